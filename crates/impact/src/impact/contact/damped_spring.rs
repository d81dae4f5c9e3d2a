//! The contact with a spring and a dashpot in closed form: a damped oscillation.
//!
//! ```text
//! d'' + 2 zeta omega d' + omega^2 d = 0,  d(0) = 0, d'(0) = v        omega = sqrt(gamma), lambda = 2 zeta/omega
//! d = v exp(-zeta omega t) sin(omega t sin b)/(omega sin b),  zeta = cos b        sinh a for sin b if zeta = cosh a
//! D = (v/omega) exp(-b cot b)                                        where omega t sin b = b
//! it pulls:      until omega t sin b = pi, where d = 0               e = exp(-pi cot b)
//! it does not:   until omega t sin b = 2 b, where the force is zero  e = exp(-2 b cot b), d = lambda e v left
//! ```
//!
//! The spring that does not pull is left behind at the depth `lambda e v`, which the body goes back without a force
//! in the time lambda. Nothing else acts.

use super::super::hertz::positive;
use super::{ContactError, Dashpot, in_range, not_negative, within};

/// A contact with a spring and a dashpot, entered with the speed v.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DampedSpring {
    /// Whether it pulls on the way out.
    pub dashpot: Dashpot,
    /// The stiffness gamma of the spring: the force, an acceleration, at depth one at rest.
    pub stiffness: f64,
    /// The damping lambda, in units of time: the force is gamma (d + lambda d').
    pub damping: f64,
    /// The damping ratio zeta = lambda sqrt(gamma)/2.
    pub damping_ratio: f64,
    /// The speed v of touch, depth per time.
    pub speed: f64,
    /// The greatest depth D, in the unit of x.
    pub depth: f64,
    /// The duration T from the touch until the depth is zero again, in the unit of time.
    pub duration: f64,
    /// The greatest force, per unit of mass: at the touch, unless zeta is below 1/2.
    pub peak_force: f64,
    /// The depth at which the force is greatest.
    pub peak_depth: f64,
    /// The coefficient of restitution e, speed out over speed in.
    pub restitution: f64,
    /// The speed e v of release.
    pub exit_speed: f64,
    /// The energy lost, (1 - e^2) v^2/2, per unit of mass.
    pub energy_lost: f64,
    /// The time at which the force ends.
    force_ends: f64,
}

impl DampedSpring {
    /// The contact of this stiffness gamma and damping lambda, touched at this speed.
    ///
    /// # Errors
    /// [`ContactError`]: a quantity outside its domain, a dashpot from which the motion does not come back, or
    /// numbers beyond double precision.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::{DampedSpring, Dashpot};
    ///
    /// let damping = 2.0 * Dashpot::Pulls.damping_ratio_for(0.8)? / 100.0;
    /// let contact = DampedSpring::new(Dashpot::Pulls, 1e4, damping, 2.0)?;
    /// let [_, velocity] = contact.phase_point(contact.duration);
    /// assert!((velocity + 1.6).abs() < 1e-12);
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn new(
        dashpot: Dashpot,
        stiffness: f64,
        damping: f64,
        speed: f64,
    ) -> Result<Self, ContactError> {
        let stiffness = positive("stiffness gamma", stiffness)?;
        let speed = positive("speed of contact", speed)?;
        let damping = not_negative("damping lambda", damping)?;
        let omega = stiffness.sqrt();
        let damping_ratio = 0.5 * damping * omega;
        let restitution = dashpot.restitution(damping_ratio)?;
        if restitution == 0.0 {
            return Err(ContactError::NeverLeaves { damping_ratio });
        }
        let exit_speed = restitution * speed;
        let mut contact = Self {
            dashpot,
            stiffness,
            damping,
            damping_ratio,
            speed,
            depth: f64::NAN,
            duration: f64::NAN,
            peak_force: damping * stiffness * speed,
            peak_depth: 0.0,
            restitution,
            exit_speed,
            energy_lost: 0.5 * (speed - exit_speed) * (speed + exit_speed),
            force_ends: f64::INFINITY,
        };
        // Angles omega t sin b over sin b: b/sin b and a/sinh a meet at zeta = 1.
        let square = (1.0 - damping_ratio) * (1.0 + damping_ratio);
        let (angle, sine) = match square > 0.0 {
            true => (damping_ratio.acos(), square.sqrt()),
            false => (damping_ratio.acosh(), (-square).sqrt()),
        };
        let per_sine = if sine > 0.0 { angle / sine } else { 1.0 };
        contact.depth = in_range("depth", contact.damped(per_sine / omega)[0])?;
        (contact.force_ends, contact.duration) = match dashpot {
            Dashpot::Pulls => {
                let end = std::f64::consts::PI / (omega * sine);
                (end, end)
            }
            Dashpot::DoesNotPull => {
                let end = 2.0 * per_sine / omega;
                (end, end + damping)
            }
        };
        in_range("duration", contact.duration)?;
        if damping_ratio < 0.5 {
            let time = (3.0 * angle - std::f64::consts::PI) / (omega * sine);
            contact.peak_depth = contact.damped(time)[0];
            contact.peak_force = contact.force(time);
        }
        in_range("peak force", contact.peak_force)?;
        Ok(contact)
    }

    /// Depth and velocity of the damped oscillation at a time.
    fn damped(&self, time: f64) -> [f64; 2] {
        let (zeta, omega) = (self.damping_ratio, self.stiffness.sqrt());
        let square = (1.0 - zeta) * (1.0 + zeta);
        let angle = omega * time * square.abs().sqrt();
        let decay = (-zeta * omega * time).exp();
        // sin(angle)/(omega sin b) and cos(angle), or their hyperbolic counterparts.
        let (sine, cosine) = match square.partial_cmp(&0.0) {
            Some(std::cmp::Ordering::Greater) => (angle.sin() * time / angle, angle.cos()),
            Some(std::cmp::Ordering::Less) => (angle.sinh() * time / angle, angle.cosh()),
            _ => (time, 1.0),
        };
        let sine = if angle == 0.0 { time } else { sine };
        let scale = self.speed * decay;
        [scale * sine, scale * (cosine - zeta * omega * sine)]
    }

    /// The force gamma (d + lambda d') of the damped oscillation at a time.
    fn force(&self, time: f64) -> f64 {
        let [depth, rate] = self.damped(time);
        self.stiffness * (depth + self.damping * rate)
    }

    /// Depth and velocity at a time since the touch, up to the release.
    pub fn phase_point(&self, time: f64) -> [f64; 2] {
        let time = within(time, self.duration);
        match self.dashpot {
            Dashpot::DoesNotPull if time > self.force_ends => {
                [self.exit_speed * (self.duration - time), -self.exit_speed]
            }
            _ => self.damped(time),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::contact::by_runge_kutta;

    /// Runge-Kutta on the contact itself: depth, duration, speed of release, and the greatest force on its way.
    #[test]
    fn a_damped_spring_is_its_damped_sine() {
        for dashpot in [Dashpot::Pulls, Dashpot::DoesNotPull] {
            for restitution in [0.999_9, 0.8, 0.5, 0.2, 0.135_335_283_236_612_7, 0.05] {
                let ratio = dashpot.damping_ratio_for(restitution).expect("a ratio");
                let contact =
                    DampedSpring::new(dashpot, 400.0, 0.1 * ratio, 3.0).expect("a contact");
                assert!((contact.restitution / restitution - 1.0).abs() < 1e-12, "{contact:?}");
                let force = |depth: f64, rate: f64| {
                    let force = 400.0 * (depth + contact.damping * rate);
                    if dashpot == Dashpot::Pulls { force } else { force.max(0.0) }
                };
                let truth = by_runge_kutta(force, [3.0, contact.depth, 10.0]);
                let end = truth.end();
                assert!((end.t / contact.duration - 1.0).abs() < 1e-9, "{contact:?} {end:?}");
                assert!((end.v + 3.0 * restitution).abs() < 1e-9, "{contact:?} {end:?}");
                let deepest = truth.occurrences()[0].state;
                assert!((deepest.x / contact.depth - 1.0).abs() < 1e-10, "{contact:?}");
                let mut greatest = [0.0_f64; 2];
                for part in 0..=4000 {
                    let time = contact.duration * f64::from(part) / 4000.0;
                    let [depth, rate] = contact.phase_point(time);
                    let found = truth.state_at(time.min(end.t)).expect("within");
                    assert!((depth - found.x).abs() < 1e-9 * contact.depth, "{contact:?} {time}");
                    assert!((rate - found.v).abs() < 1e-8, "{contact:?} {time}");
                    if force(depth, rate) > greatest[0] {
                        greatest = [force(depth, rate), depth];
                    }
                }
                assert!((greatest[0] / contact.peak_force - 1.0).abs() < 1e-6, "{contact:?}");
                assert!((greatest[1] - contact.peak_depth).abs() < 2e-3 * contact.depth);
                let lost = 0.5 * (9.0 - end.v * end.v);
                assert!((lost - contact.energy_lost).abs() < 1e-8);
            }
        }
        for (stiffness, damping, speed) in [
            (0.0, 0.5, 1.0),
            (1.0, -0.1, 1.0),
            (1.0, 0.5, -1.0),
            (1.0, 2.0, 1.0),
            (1.0, f64::NAN, 1.0),
        ] {
            DampedSpring::new(Dashpot::Pulls, stiffness, damping, speed).expect_err("refused");
        }
    }
}

//! Contacts with a dashpot: their coefficient of restitution, and the damping that gives one.
//!
//! ```text
//! m p'' + c p' + K p = 0,  p(0) = 0, p'(0) = v          zeta = c/(2 sqrt(K m)), omega = sqrt(K/m)
//! e = exp(-pi zeta/sqrt(1 - zeta^2))                    until p = 0: the contact pulls on the way out
//! e = exp(-2 b cot b),  zeta = cos b                    until p'' = 0: it does not; b cot b = a coth a if zeta = cosh a
//! ```
//!
//! The second: p is the imaginary part of `exp(lambda t)` with `lambda = omega exp(i (pi - b))`, up to
//! a factor, so p'' vanishes where `omega t sin b = 2 b`, and there `p' = -v exp(-omega zeta t)`.
//! (B. Brogliato, *Nonsmooth Mechanics*, 3rd ed., Springer 2016, chapter 2.)
//!
//! A dashpot that comes in by a cubic step, `m p'' = -max(K p^n + c S(p/d) p', 0)`, has no closed form.
//! In units of v and of the depth D0 without damping, `(n + 1) m v^2 = 2 K D0^(n+1)`, it is
//!
//! ```text
//! y'' = -max((n + 1)/2 y^n + kappa S(y/delta) y', 0),   kappa = c D0/(m v),   delta = d/D0
//! ```

use std::f64::consts::PI;

use super::super::hertz::positive;
use super::{ContactError, in_range, not_negative};
use crate::numeric::ode::root::find_root;
use crate::numeric::ode::{Event, IntegrationOptions, IntegrationPhase, State, integrate_phases};

/// A spring with a dashpot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dashpot {
    /// The contact ends where the penetration does, and pulls shortly before.
    Pulls,
    /// The contact ends where its force does.
    DoesNotPull,
}

impl Dashpot {
    /// Both, in the order of a table.
    pub const ALL: [Self; 2] = [Self::Pulls, Self::DoesNotPull];

    /// The name of the law, as in a problem file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pulls => "kelvin-voigt",
            Self::DoesNotPull => "kelvin-voigt-no-pull",
        }
    }

    /// The coefficient of restitution by the damping ratio zeta = c/(2 sqrt(K m)), whatever the speed.
    ///
    /// # Errors
    /// [`ContactError::Negative`] for a ratio that is negative or not a number.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::Dashpot;
    ///
    /// let critical = Dashpot::DoesNotPull.restitution(1.0)?;
    /// assert!((critical - (-2.0_f64).exp()).abs() < 1e-15);
    /// assert_eq!(Dashpot::Pulls.restitution(1.0)?, 0.0);
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn restitution(self, damping_ratio: f64) -> Result<f64, ContactError> {
        let zeta = not_negative("damping ratio", damping_ratio)?;
        Ok(match self {
            Self::Pulls if zeta >= 1.0 => 0.0,
            Self::Pulls => (-PI * zeta / ((1.0 - zeta) * (1.0 + zeta)).sqrt()).exp(),
            Self::DoesNotPull => (-2.0 * half_loss(zeta)).exp(),
        })
    }

    /// The damping ratio zeta = c/(2 sqrt(K m)) of a contact with this coefficient of restitution.
    ///
    /// # Errors
    /// [`ContactError::Restitution`] for one that is not above 0 and at most 1.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::Dashpot;
    ///
    /// let zeta = Dashpot::DoesNotPull.damping_ratio_for(0.8)?;
    /// assert!((Dashpot::DoesNotPull.restitution(zeta)? - 0.8).abs() < 1e-14);
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn damping_ratio_for(self, restitution: f64) -> Result<f64, ContactError> {
        let loss = -known(restitution)?.ln();
        match self {
            Self::Pulls => Ok(loss / PI.hypot(loss)),
            // a coth a >= a bounds the ratio cosh a.
            Self::DoesNotPull => {
                let highest = (0.5 * loss).cosh() * (1.0 + 4.0 * f64::EPSILON);
                Ok(find_root(|zeta| half_loss(zeta) - 0.5 * loss, 0.0, highest)?)
            }
        }
    }
}

/// b cot b for zeta = cos b, a coth a for zeta = cosh a: half of -ln e, growing with zeta.
fn half_loss(zeta: f64) -> f64 {
    let square = (1.0 - zeta) * (1.0 + zeta);
    match square.partial_cmp(&0.0) {
        Some(std::cmp::Ordering::Greater) => zeta * zeta.acos() / square.sqrt(),
        Some(std::cmp::Ordering::Less) => zeta.acosh() / (-square).sqrt() * zeta,
        _ => 1.0,
    }
}

/// A contact whose dashpot comes in by a cubic step of the penetration, touched with speed v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepContact {
    /// The exponent n > 0 of the elastic force.
    pub exponent: f64,
    /// The stiffness K, force per length^n.
    pub stiffness: f64,
    /// The penetration d of full damping.
    pub depth: f64,
    /// The mass m that meets the wall.
    pub mass: f64,
    /// The speed v of touch.
    pub speed: f64,
}

impl StepContact {
    /// The greatest depth without damping.
    fn undamped_depth(&self) -> Result<f64, ContactError> {
        let Self { exponent, stiffness, depth, mass, speed } = *self;
        for (name, value) in [
            ("exponent", exponent),
            ("stiffness", stiffness),
            ("depth of full damping", depth),
            ("mass", mass),
            ("speed", speed),
        ] {
            positive(name, value)?;
        }
        let order = exponent + 1.0;
        in_range(
            "depth",
            (0.5 * order * mass / stiffness).powf(order.recip()) * speed.powf(2.0 / order),
        )
    }

    /// The coefficient of restitution with a damping coefficient c, force per speed, in full.
    ///
    /// # Errors
    /// [`ContactError`] for a quantity that is not positive, or a damping that is negative.
    pub fn restitution(&self, damping: f64) -> Result<f64, ContactError> {
        let depth = self.undamped_depth()?;
        let damping = not_negative("damping", damping * depth / (self.mass * self.speed))?;
        Ok(exit_speed(self.exponent, self.depth / depth, damping))
    }

    /// The damping coefficient c, force per speed, of a contact with this coefficient of restitution.
    ///
    /// # Errors
    /// [`ContactError`] for a quantity that is not positive, a restitution that is not above 0 and at
    /// most 1, or one below what any damping gives.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::StepContact;
    ///
    /// let contact = StepContact { exponent: 1.5, stiffness: 1e5, depth: 1e-3, mass: 2.0, speed: 0.5 };
    /// let damping = contact.damping_for(0.7)?;
    /// assert!((contact.restitution(damping)? - 0.7).abs() < 1e-10);
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn damping_for(&self, restitution: f64) -> Result<f64, ContactError> {
        const DOUBLINGS: usize = 24;
        let depth = self.undamped_depth()?;
        if known(restitution)? == 1.0 {
            return Ok(0.0);
        }
        let missing =
            |damping: f64| exit_speed(self.exponent, self.depth / depth, damping) - restitution;
        let mut highest = 1.0;
        for _ in 0..DOUBLINGS {
            if missing(highest) < 0.0 {
                let damping = find_root(missing, 0.0, highest)?;
                return in_range("damping", damping * self.mass * self.speed / depth);
            }
            highest *= 2.0;
        }
        Err(ContactError::Range { quantity: "damping" })
    }
}

/// The speed of release over that of touch, of the contact without units: its right side has corners
/// where the step is over and where the force is limited, at which phases of the integration meet.
fn exit_speed(exponent: f64, ramp: f64, damping: f64) -> f64 {
    /// A contact that has not ended by then creeps out.
    const LONGEST: f64 = 1e4;
    const WITHIN: usize = 0;
    const BEYOND: usize = 1;
    const FREE: usize = 2;
    let elastic = move |y: f64| 0.5 * (exponent + 1.0) * y.max(0.0).powf(exponent);
    let within = move |y: f64, rate: f64| {
        let part = y / ramp;
        elastic(y) + damping * part * part * (3.0 - 2.0 * part) * rate
    };
    let beyond = move |y: f64, rate: f64| elastic(y) + damping * rate;
    let force = move |y: f64, rate: f64| match y < ramp {
        true => within(y, rate),
        false => beyond(y, rate),
    };
    let released = || Event::stop(|_, y, _| y).falling();
    let at_ramp = |next: usize| {
        Event::switch(move |_, y, _| y - ramp, move |state| (next, State { x: ramp, ..state }))
    };
    let let_go = |force: Box<dyn Fn(f64, f64) -> f64>| {
        Event::switch(move |_, y, rate| force(y, rate), |state| (FREE, state)).falling()
    };
    let held_again = move |state: State| (if state.x < ramp { WITHIN } else { BEYOND }, state);
    let phases = [
        IntegrationPhase::new(
            move |_, y, rate| -within(y, rate),
            vec![released(), at_ramp(BEYOND).rising(), let_go(Box::new(within))],
        ),
        IntegrationPhase::new(
            move |_, y, rate| -beyond(y, rate),
            vec![at_ramp(WITHIN).falling(), let_go(Box::new(beyond))],
        ),
        IntegrationPhase::new(
            |_, _, _| 0.0,
            vec![released(), Event::switch(move |_, y, rate| force(y, rate), held_again).rising()],
        ),
    ];
    let options = IntegrationOptions {
        absolute_tolerance: 1e-14,
        ..IntegrationOptions::with_tolerance(1e-13)
    };
    let start = State { t: 0.0, x: 0.0, v: 1.0 };
    match integrate_phases(&phases, WITHIN, start, LONGEST, &options) {
        Ok(path) if path.end().t < LONGEST => -path.end().v,
        _ => 0.0,
    }
}

/// A coefficient of restitution above 0 and at most 1.
fn known(restitution: f64) -> Result<f64, ContactError> {
    match restitution > 0.0 && restitution <= 1.0 {
        true => Ok(restitution),
        false => Err(ContactError::Restitution(restitution)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::contact::by_runge_kutta;
    use crate::numeric::ode::integrate;

    /// Runge-Kutta on the contact itself, until the gap opens or the force has gone.
    #[test]
    fn a_spring_with_a_dashpot_leaves_with_the_speed_of_its_closed_form() {
        for zeta in [1e-6, 0.1, 0.5, 0.9, 0.999_999, 1.0, 1.5, 10.0] {
            if zeta < 0.95 {
                let pulled = by_runge_kutta(|p, rate| p + 2.0 * zeta * rate, [1.0, 1.0, 50.0]);
                let e = Dashpot::Pulls.restitution(zeta).expect("a ratio");
                assert!((-pulled.end().v - e).abs() < 1e-11, "{zeta}: {e}");
            }
            let force = |p: f64, rate: f64| p + 2.0 * zeta * rate;
            let let_go = Event::stop(move |_, p, rate| force(p, rate)).falling();
            let options = IntegrationOptions::with_tolerance(1e-13);
            let start = State { t: 0.0, x: 1e-300, v: 1.0 };
            let path = integrate(|_, p, v| -force(p, v), start, 1e3, &[let_go], &options);
            let e = Dashpot::DoesNotPull.restitution(zeta).expect("a ratio");
            let found = -path.expect("a path").end().v;
            assert!((found - e).abs() < 1e-11, "{zeta}: {e} {found}");
        }
    }

    #[test]
    fn damping_and_restitution_lead_to_each_other() {
        for e in [1.0, 0.999_999, 0.8, 0.3, 0.135_335_283, 1e-3, 1e-9] {
            for dashpot in [Dashpot::Pulls, Dashpot::DoesNotPull] {
                let zeta = dashpot.damping_ratio_for(e).expect("a ratio");
                let back = dashpot.restitution(zeta).expect("a restitution");
                assert!((back / e - 1.0).abs() < 1e-9, "{dashpot:?} {e}: {zeta} {back}");
            }
        }
        for wrong in [0.0, -0.5, 1.5, f64::NAN] {
            let refused = Dashpot::Pulls.damping_ratio_for(wrong);
            assert!(matches!(refused, Err(ContactError::Restitution(_))), "{wrong}");
        }
    }

    /// A step that is over at once is a dashpot that does not pull.
    #[test]
    fn a_short_step_is_a_dashpot() {
        let contact =
            StepContact { exponent: 1.0, stiffness: 50.0, depth: 1e-7, mass: 2.0, speed: 0.3 };
        for e in [0.9, 0.5, 0.2] {
            let zeta = Dashpot::DoesNotPull.damping_ratio_for(e).expect("a ratio");
            let found = contact.damping_for(e).expect("a damping");
            let expected = 2.0 * zeta * (50.0_f64 * 2.0).sqrt();
            assert!((found / expected - 1.0).abs() < 1e-4, "{e}: {found} {expected}");
        }
    }

    /// The energy lost is the work of the dashpot, by quadrature over the depth: to the first order in
    /// the damping both ways are those without damping.
    #[test]
    fn little_damping_takes_its_work_along_the_motion_without_it() {
        use crate::numeric::ode::quadrature::integrate_smooth;
        let (n, ramp, damping) = (1.5_f64, 0.4_f64, 1e-5);
        // y = sin(phi)^(2/(n+1)) has the speed cos(phi).
        let work = |phi: f64| {
            let power = 2.0 / (n + 1.0);
            let part = (phi.sin().powf(power) / ramp).min(1.0);
            let step = part * part * (3.0 - 2.0 * part);
            step * phi.cos() * power * phi.sin().powf(power - 1.0) * phi.cos()
        };
        let corner = ramp.powf((n + 1.0) / 2.0).asin();
        let pieces = [[0.0, corner], [corner, 0.5 * PI]];
        let lost: f64 = pieces
            .map(|[from, to]| integrate_smooth(work, from, to, 1e-12).expect("an integral").0)
            .iter()
            .sum();
        let contact =
            StepContact { exponent: n, stiffness: 1.25, depth: ramp, mass: 1.0, speed: 1.0 };
        let e = contact.restitution(damping).expect("a restitution");
        assert!(((1.0 - e) / (2.0 * damping * lost) - 1.0).abs() < 1e-4, "{e}: {lost}");
    }

    #[test]
    fn a_step_without_a_mass_is_refused() {
        let contact =
            StepContact { exponent: 1.5, stiffness: 1.0, depth: 0.1, mass: 0.0, speed: 1.0 };
        let error = contact.damping_for(0.5).expect_err("no mass").to_string();
        assert!(error.contains("mass"), "{error}");
    }
}

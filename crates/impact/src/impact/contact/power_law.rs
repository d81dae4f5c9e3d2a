//! The contact of a power law, in closed form: d'' = -gamma d^n.
//!
//! References: H. Hertz, *J. reine angew. Math.* 92 (1881) 156, for n = 3/2; W.
//! Goldsmith, *Impact*, 1960, section 4.2; K. L. Johnson, *Contact Mechanics*, 1985, section 11.4. With m =
//! n + 1, B the beta function and I the regularised incomplete one,
//!
//! ```text
//! D = (m v^2/(2 gamma))^(1/m)                     T = (2 D/(m v)) B(1/m, 1/2),   B(1/m, 1/2) = sqrt(pi) Gamma(1/m)/Gamma(1/m + 1/2)
//! peak force = gamma D^n = m v^2/(2 D)
//! s = (T/2) I_x(1/m, 1/2),   x = (d/D)^m,         d' = v sqrt(1 - x)            for the rise; the fall is its mirror image
//! ```
//!
//! Near the deepest point x is 1 but for little, and the complement is solved instead:
//! `1 - 2 s/T = I_z(1/2, 1/m)`, z = (d'/v)^2.
//!
//! With a force a at touch and a slope k beside the contact, d'' + a + k d + gamma d^n = 0, the
//! energy gives, exactly,
//!
//! ```text
//! 1 = E1 r + E2 r^2 + r^m,   r = D/D0,            E1 = 2 a D0/v^2,  E2 = k D0^2/v^2,  D0 the depth above
//! T = (2 D/v) int_0^1 dy / sqrt(1 - y^m - e1 (y - y^m) - e2 (y^2 - y^m)),     e1 = 2 a D/v^2,  e2 = k D^2/v^2
//! ```
//!
//! and both in powers of a and k have coefficients in closed form, the first by Lagrange's
//! inversion, the second by the binomial series, every integral of which is a beta function,
//! continued analytically where it diverges by itself:
//!
//! ```text
//! r = sum_(p,q) (-E1)^p (-E2)^q / (p! q!) (1/m) (alpha - 1) .. (alpha - p - q + 1),            alpha = (1 + p + 2 q)/m
//! T = (2 D/v) sum_(p,q) e1^p e2^q (1/2)_(p+q) / (p! q!) sum_(i<=p, j<=q) (-1)^(i+j) C(p,i) C(q,j) (1/m) B(beta, 1/2 - p - q),
//!                                                                beta = (1 + p - i + 2 (q - j))/m + i + j
//! ```
//!
//! The series of T converges for |e1| < m/n, that is 5/3 for Hertz, where e1 = 1 is a contact of
//! which the force at touch alone takes up the whole energy; those of r for a little less. For a
//! soft barrier or a slow touch use the exact contact.

use std::f64::consts::PI;

use spec_math::cephes64::{beta, gamma, incbet, rgamma};

use super::super::hertz::{DEFAULT_STIFFNESS, positive};
use super::{ContactError, finite, in_range, within};
use crate::decimal::significant;
use crate::numeric::ode::root::find_root;

/// One contact by d'' = -gamma d^n, entered with speed v. Made by [`PowerLaw::new`], so that all
/// fields belong together.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PowerLaw {
    /// The exponent n > 0 of the force, 3/2 for Hertz.
    pub exponent: f64,
    /// The stiffness gamma: the force, an acceleration, at depth one.
    pub stiffness: f64,
    /// The speed v of touch, depth per time.
    pub speed: f64,
    /// The greatest depth D, in the unit of x.
    pub depth: f64,
    /// The duration T, in the unit of time.
    pub duration: f64,
    /// The greatest force gamma D^n, per unit of mass.
    pub peak_force: f64,
}

/// The default: a Hertz contact of the default stiffness, touched at unit speed.
impl Default for PowerLaw {
    fn default() -> Self {
        let (exponent, speed) = (1.5, 1.0);
        let depth = greatest_depth(exponent, DEFAULT_STIFFNESS, speed);
        Self::with_depth(exponent, DEFAULT_STIFFNESS, speed, depth)
    }
}

impl PowerLaw {
    /// The contact of this exponent and this stiffness gamma, touched at this speed.
    ///
    /// # Errors
    /// [`ContactError`]: a quantity that is not a positive number, a depth or a duration beyond
    /// double precision.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::PowerLaw;
    ///
    /// let hertz = PowerLaw::new(1.5, 1e6, 1.0)?;
    /// assert!((hertz.duration * hertz.speed / hertz.depth - 2.943_275_184_324_70).abs() < 1e-13);
    /// assert!((hertz.phase_point_at(hertz.duration / 2.0).0 - hertz.depth).abs() < 1e-15);
    /// assert!((hertz.velocity(hertz.duration) + 1.0).abs() < 1e-15); // it leaves as fast as it came
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn new(exponent: f64, stiffness: f64, speed: f64) -> Result<Self, ContactError> {
        let exponent = positive("exponent of the force", exponent)?;
        let stiffness = positive("stiffness gamma", stiffness)?;
        let speed = positive("speed of contact", speed)?;
        let depth = in_range("depth", greatest_depth(exponent, stiffness, speed))?;
        let contact = Self::with_depth(exponent, stiffness, speed, depth);
        in_range("duration", contact.duration)?;
        in_range("peak force", contact.peak_force)?;
        Ok(contact)
    }

    fn with_depth(exponent: f64, stiffness: f64, speed: f64, depth: f64) -> Self {
        Self {
            exponent,
            stiffness,
            speed,
            depth,
            duration: duration_factor(exponent) * depth / speed,
            peak_force: 0.5 * (exponent + 1.0) * speed / depth * speed,
        }
    }

    /// Depth and velocity at a time since touch; before and after the contact those of its ends.
    ///
    /// Good to 1e-13 of D and v.
    pub fn phase_point_at(&self, time: f64) -> (f64, f64) {
        let (depth, velocity) = pulse(self.exponent, time / self.duration);
        (self.depth * depth, self.speed * velocity)
    }

    /// The depth at a time since touch, in the unit of x.
    pub fn position(&self, time: f64) -> f64 {
        self.phase_point_at(time).0
    }

    /// The velocity at a time since touch, positive into the barrier.
    pub fn velocity(&self, time: f64) -> f64 {
        self.phase_point_at(time).1
    }

    /// The contact with a force `preload` (a, of either sign) at touch and of slope `slope` (k)
    /// beside it, to this order in both together, at most [`HIGHEST_ORDER`].
    ///
    /// # Errors
    /// [`ContactError::NoCorrection`] where the terms left out may be half of the depth or of the
    /// duration; [`ContactError`] for numbers that are not finite and for an order that does not
    /// exist.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::PowerLaw;
    ///
    /// // Gravity at the paper's barrier: sin 0.323 and cos 0.323.
    /// let hertz = PowerLaw::new(1.5, 1e6, 1.0)?;
    /// let pendulum = hertz.corrected(0.323_f64.sin(), 0.323_f64.cos(), 2)?;
    /// assert!(pendulum.depth < hertz.depth && pendulum.duration < hertz.duration);
    /// assert!(pendulum.duration_error < 1e-5);
    /// assert!(PowerLaw::new(1.5, 1.0, 0.01)?.corrected(0.3, 0.9, 2).is_err()); // a push, no impact
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn corrected(
        &self,
        preload: f64,
        slope: f64,
        order: u32,
    ) -> Result<CorrectedPowerLaw, ContactError> {
        let (preload, slope) =
            (finite("force at touch", preload)?, finite("slope of the force", slope)?);
        if !(1..=HIGHEST_ORDER).contains(&order) {
            return Err(ContactError::Order { order, highest: HIGHEST_ORDER });
        }
        let scale = self.depth / self.speed;
        let by_preload = 2.0 * preload / self.speed * scale;
        let by_slope = slope * scale * scale;
        let m = self.exponent + 1.0;
        let (ratio, depth_error) =
            double_series(order, [-by_preload, -by_slope], |p, q| depth_coefficient(m, p, q));
        let whole = duration_coefficient(m, 0, 0);
        let at_depth = [by_preload * ratio, by_slope * ratio * ratio];
        let (factor, duration_error) =
            double_series(order, at_depth, |p, q| duration_coefficient(m, p, q) / whole);
        let corrected = CorrectedPowerLaw {
            contact: *self,
            preload,
            slope,
            order,
            depth: self.depth * ratio,
            duration: self.duration * ratio * factor,
            depth_error: depth_error / ratio,
            duration_error: duration_error / factor + depth_error / ratio,
        };
        let small = |error: f64| (0.0..0.5).contains(&error);
        if !(ratio > 0.0
            && factor > 0.0
            && small(corrected.depth_error)
            && small(corrected.duration_error))
        {
            return Err(ContactError::NoCorrection {
                depth_error: corrected.depth_error.abs(),
                duration_error: corrected.duration_error.abs(),
            });
        }
        in_range("depth", corrected.depth)?;
        in_range("duration", corrected.duration)?;
        Ok(corrected)
    }
}

/// The highest order of a correction: beyond it the terms of T cancel.
pub const HIGHEST_ORDER: u32 = 6;

/// A [`PowerLaw`] corrected for the force at touch and its slope. Made by [`PowerLaw::corrected`].
///
/// Depth and duration are those of the series above. The motion is the parabola that the force at
/// touch alone would drive, and the rest of the depth in the shape of the power law:
///
/// ```text
/// d(s) = (a/2) s (T - s) + (D - a T^2/8) Y(s/T),       Y the motion of the power law, of unit depth and duration
/// ```
///
/// D, T and the acceleration at touch are exact in it, the speed of touch to about first order; its
/// distance from the exact motion is [`CorrectedPowerLaw::shape_error`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CorrectedPowerLaw {
    /// The contact without the correction.
    pub contact: PowerLaw,
    /// The force a at touch, per unit of mass, positive out of the barrier.
    pub preload: f64,
    /// The slope k of that force, per time squared.
    pub slope: f64,
    /// The order of the correction.
    pub order: u32,
    /// The greatest depth D, in the unit of x.
    pub depth: f64,
    /// The duration T, in the unit of time.
    pub duration: f64,
    /// The terms of the last order of the depth, relative to it: what may still be missing.
    pub depth_error: f64,
    /// The terms of the last order of the duration, relative to it, with those of the depth.
    pub duration_error: f64,
}

impl CorrectedPowerLaw {
    /// The greatest force a + k D + gamma D^n, per unit of mass.
    pub fn peak_force(&self) -> f64 {
        let PowerLaw { exponent, peak_force, depth, .. } = self.contact;
        self.preload + self.slope * self.depth + peak_force * (self.depth / depth).powf(exponent)
    }

    /// Depth and velocity at a time since touch; before and after the contact those of its ends.
    pub fn phase_point_at(&self, time: f64) -> (f64, f64) {
        let time = within(time, self.duration);
        let PowerLaw { exponent, .. } = self.contact;
        let (depth, velocity) = pulse(exponent, time / self.duration);
        let rest = self.depth - 0.125 * self.preload * self.duration * self.duration;
        (
            0.5 * self.preload * time * (self.duration - time) + rest * depth,
            0.5 * self.preload * (self.duration - 2.0 * time)
                + rest * duration_factor(exponent) / self.duration * velocity,
        )
    }

    /// The depth at a time since touch, in the unit of x.
    pub fn position(&self, time: f64) -> f64 {
        self.phase_point_at(time).0
    }

    /// The velocity at a time since touch, positive into the barrier.
    pub fn velocity(&self, time: f64) -> f64 {
        self.phase_point_at(time).1
    }

    /// The formula in the usual form, this many significant digits: s is the time since touch, Y
    /// the motion of the power law.
    pub fn closed_form(&self, digits: usize) -> String {
        let duration = significant(self.duration, digits);
        let rest = self.depth - 0.125 * self.preload * self.duration * self.duration;
        let shape = format!("{} Y(s/{duration})", significant(rest, digits));
        if self.preload == 0.0 {
            return format!("d(s) = {shape}");
        }
        format!("d(s) = {} s ({duration} - s) + {shape}", significant(0.5 * self.preload, digits))
    }

    /// Relative error of the speed at touch: a measure of the error of the shape of the motion,
    /// whose depth is off by less than that times D (as long as |a| D < v^2/10).
    pub fn shape_error(&self) -> f64 {
        (self.velocity(0.0) / self.contact.speed - 1.0).abs()
    }
}

/// D of the power law: (m v^2/(2 gamma))^(1/m), power by power so that no square leaves the range.
fn greatest_depth(exponent: f64, stiffness: f64, speed: f64) -> f64 {
    let inverse = 1.0 / (exponent + 1.0);
    (0.5 * (exponent + 1.0)).powf(inverse) * speed.powf(2.0 * inverse) * stiffness.powf(-inverse)
}

/// n, if this force is proportional to d^n at depths from 1e-9 to 4, to the accuracy of doubles;
/// `None` otherwise.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::contact::power_law::exponent_of;
///
/// assert_eq!(exponent_of(|d| 3e6 * d * d), Some(2.0));
/// assert_eq!(exponent_of(|d| d + d.powi(3)), None);
/// ```
pub fn exponent_of(force: impl Fn(f64) -> f64) -> Option<f64> {
    let unit = force(1.0);
    let slope = (force(4.0) / unit).log2() / 2.0;
    // Exponents have few digits; the logarithm has lost only the last ones.
    let written = (slope * 1e6).round() / 1e6;
    let exponent = if (slope - written).abs() < 1e-13 * written { written } else { slope };
    let is_power = |power: i32| {
        let depth = 2.0_f64.powi(power);
        (force(depth) / unit / depth.powf(exponent) - 1.0).abs() < 1e-11
    };
    (unit > 0.0 && exponent.is_finite() && (-30..=2).step_by(4).all(is_power)).then_some(exponent)
}

/// The number T v/D of the power law, (2/m) B(1/m, 1/2): 2.9432751843247 for Hertz, pi for a
/// spring, 4 for a constant force.
pub fn duration_factor(exponent: f64) -> f64 {
    let inverse = 1.0 / (exponent + 1.0);
    2.0 * inverse * beta(inverse, 0.5)
}

/// The motion of the power law in its own units: d/D and d'/v at a part of the duration between 0
/// and 1.
pub fn pulse(exponent: f64, part: f64) -> (f64, f64) {
    let part = within(part, 1.0);
    let (m, inverse) = (exponent + 1.0, 1.0 / (exponent + 1.0));
    let (since, sign) = if part <= 0.5 { (2.0 * part, 1.0) } else { (2.0 * (1.0 - part), -1.0) };
    // Up to x = 1/2 the depth is the unknown, from there on the velocity: neither then is a
    // difference of nearly equal numbers.
    let (depth, velocity) = if since <= incbet(inverse, 0.5, 0.5) {
        let linear = since * 0.5 * duration_factor(exponent);
        let late = |y: f64| incbet(inverse, 0.5, y.powf(m)) - since;
        // Below this depth the velocity is still v to double precision, and x would underflow.
        let depth = match linear.powf(m) < 1e-17 {
            true => linear,
            false => find_root(late, 0.0, 1.0).unwrap_or(linear),
        };
        (depth, (1.0 - depth.powf(m)).sqrt())
    } else {
        let early = |u: f64| incbet(0.5, inverse, u * u) - (1.0 - since);
        let velocity = find_root(early, 0.0, 1.0).unwrap_or(0.0);
        ((1.0 - velocity * velocity).powf(inverse), velocity)
    };
    (depth, sign * velocity)
}

/// A series in two small quantities up to an order, and an estimate of its error: the terms of the
/// last order by their sizes, or those before them times the square of the quantities where the
/// last happen to vanish.
fn double_series(order: u32, small: [f64; 2], coefficient: impl Fn(i32, i32) -> f64) -> (f64, f64) {
    let order = order as i32;
    let (mut sum, mut last, mut before) = (0.0, 0.0, 0.0);
    for total in 0..=order {
        before = last;
        last = 0.0;
        for q in 0..=total {
            let term = coefficient(total - q, q) * small[0].powi(total - q) * small[1].powi(q);
            sum += term;
            last += term.abs();
        }
    }
    (sum, last.max(before * (small[0].abs() + small[1].abs()).powi(2)))
}

/// The coefficient of (-E1)^p (-E2)^q in D/D0.
fn depth_coefficient(m: f64, p: i32, q: i32) -> f64 {
    if p + q == 0 {
        return 1.0;
    }
    let alpha = f64::from(1 + p + 2 * q) / m;
    let falling = (1..p + q).map(|k| alpha - f64::from(k)).product::<f64>();
    falling / (m * factorial(p) * factorial(q))
}

/// The coefficient of e1^p e2^q in T v/(2 D).
fn duration_coefficient(m: f64, p: i32, q: i32) -> f64 {
    let order = p + q;
    let rising = (0..order).map(|k| 0.5 + f64::from(k)).product::<f64>();
    let mut sum = 0.0;
    for i in 0..=p {
        for j in 0..=q {
            let sign = if (i + j) % 2 == 0 { 1.0 } else { -1.0 };
            let exponent = f64::from(1 + p - i + 2 * (q - j)) / m + f64::from(i + j);
            sum += sign * binomial(p, i) * binomial(q, j) * continued_beta(exponent, order);
        }
    }
    rising / (factorial(p) * factorial(q)) * sum / m
}

/// B(x, 1/2 - r) = Gamma(x) Gamma(1/2 - r) / Gamma(x + 1/2 - r) for x > 0 and a whole r, zero where
/// the last has a pole.
fn continued_beta(x: f64, r: i32) -> f64 {
    // Gamma(1/2 - r) = sqrt(pi) / ((-1/2)(-3/2) .. (1/2 - r)).
    let below = (0..r).map(|k| -0.5 - f64::from(k)).product::<f64>();
    gamma(x) * PI.sqrt() / below * rgamma(x + 0.5 - f64::from(r))
}

fn factorial(n: i32) -> f64 {
    (1..=n).map(f64::from).product()
}

fn binomial(n: i32, k: i32) -> f64 {
    factorial(n) / (factorial(k) * factorial(n - k))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::contact::by_runge_kutta;
    use crate::impact::hertz;
    use crate::numeric::ode::Trajectory;
    use crate::numeric::ode::quadrature::integrate_smooth;
    use proptest::prelude::*;

    const EXPONENTS: [f64; 6] = [0.5, 1.0, 1.5, 2.0, 3.0, 7.0];
    const STIFFNESSES: [f64; 4] = [1.0, 1e3, 1e6, 1e9];
    const SPEEDS: [f64; 4] = [1e-6, 1e-3, 1.0, 10.0];

    /// int_0^y dy/sqrt(1 - y^m) by quadrature: from the deepest point, y = 1 - w^2 with 1 - y^m in
    /// full precision.
    fn rise_time(m: f64, y: f64) -> f64 {
        let smooth = |w: f64| 2.0 * w / (-(m * (-w * w).ln_1p()).exp_m1()).sqrt();
        // y = q^(1/..) is smooth at zero for whole powers only: the quadrature halves its panels
        // there.
        let whole =
            |from: f64| integrate_smooth(smooth, 0.0, (1.0 - from).sqrt(), 1e-14).unwrap().0;
        whole(0.0) - whole(y)
    }

    /// The contact with a force at touch and a slope, by Runge-Kutta.
    fn integrated(contact: &PowerLaw, preload: f64, slope: f64) -> Trajectory {
        let PowerLaw { exponent, stiffness, speed, depth, duration, .. } = *contact;
        by_runge_kutta(
            |d, _| preload + slope * d + stiffness * d.max(0.0).powf(exponent),
            [speed, depth, 100.0 * duration],
        )
    }

    #[test]
    fn depth_and_duration_over_the_grid() {
        for exponent in EXPONENTS {
            let m = exponent + 1.0;
            let factor = 2.0 * rise_time(m, 1.0);
            assert!(
                (duration_factor(exponent) / factor - 1.0).abs() < 1e-12,
                "{exponent}: {factor}"
            );
            let gammas = PI.sqrt() * gamma(1.0 / m) / gamma(1.0 / m + 0.5);
            assert!((duration_factor(exponent) / (2.0 / m * gammas) - 1.0).abs() < 1e-14);
            for stiffness in STIFFNESSES {
                for speed in SPEEDS {
                    let contact = PowerLaw::new(exponent, stiffness, speed).unwrap();
                    let stored = stiffness * contact.depth.powf(m) / m;
                    assert!(
                        (stored / (0.5 * speed * speed) - 1.0).abs() < 1e-13,
                        "energy of {contact:?}"
                    );
                    assert!(
                        (contact.peak_force / (stiffness * contact.depth.powf(exponent)) - 1.0)
                            .abs()
                            < 1e-13
                    );
                    assert!(
                        (contact.duration * speed / contact.depth / factor - 1.0).abs() < 1e-12
                    );
                    if exponent == 1.5 {
                        assert!(
                            (contact.depth / hertz::penetration(stiffness, speed).unwrap() - 1.0)
                                .abs()
                                < 1e-14
                        );
                        assert!(
                            (contact.duration / hertz::duration(stiffness, speed).unwrap() - 1.0)
                                .abs()
                                < 1e-14
                        );
                    }
                }
            }
        }
        assert_eq!(PowerLaw::default(), PowerLaw::new(1.5, DEFAULT_STIFFNESS, 1.0).unwrap());
    }

    #[test]
    fn a_spring_is_a_half_sine_and_a_constant_force_nearly_a_parabola() {
        for index in 0..=1000 {
            let part = f64::from(index) / 1000.0;
            let (depth, velocity) = pulse(1.0, part);
            assert!(
                (depth - (PI * part).sin()).abs() < 1e-14
                    && (velocity - (PI * part).cos()).abs() < 1e-14
            );
            // y' ' = -(m/2) y^n in these units of time, with n towards 0: y = 1 - (1 - 2 part)^2.
            let (depth, velocity) = pulse(1e-9, part);
            assert!(
                (depth - 4.0 * part * (1.0 - part)).abs() < 1e-8
                    && (velocity - (1.0 - 2.0 * part)).abs() < 1e-8
            );
        }
    }

    #[test]
    fn the_motion_inverts_the_time_to_twelve_places() {
        for exponent in [0.1, 0.5, 1.0, 1.5, 2.0, 3.0, 20.0] {
            let half = 0.5 * duration_factor(exponent);
            for index in 0..=200 {
                let y = f64::from(index) / 200.0;
                let part = 0.5 * rise_time(exponent + 1.0, y) / half;
                let (depth, velocity) = pulse(exponent, part);
                let expected = (-((exponent + 1.0) * y.ln()).exp_m1()).max(0.0).sqrt();
                // At the deepest point an error of the time is squared in the depth, not in the
                // velocity.
                assert!((depth - y).abs() < 1e-12, "{exponent}, depth {y}: {depth}");
                assert!(
                    (velocity - expected).abs() < 1e-12 * half,
                    "{exponent}, velocity at {y}: {velocity} against {expected}"
                );
                let (mirrored, back) = pulse(exponent, 1.0 - part);
                assert!((mirrored - depth).abs() < 1e-12 && (back + velocity).abs() < 1e-12 * half);
            }
        }
    }

    #[test]
    fn the_motion_is_that_of_runge_kutta() {
        for exponent in [1.0, 1.5, 2.0, 3.0] {
            for (stiffness, speed) in [(1.0, 1.0), (1e9, 1e-6), (1e6, 10.0), (3e7, 1.3)] {
                let contact = PowerLaw::new(exponent, stiffness, speed).unwrap();
                let path = integrated(&contact, 0.0, 0.0);
                assert!((path.end().t / contact.duration - 1.0).abs() < 1e-10);
                for state in path.samples(101) {
                    let (depth, velocity) = contact.phase_point_at(state.t);
                    assert!(
                        (depth - state.x).abs() < 1e-10 * contact.depth,
                        "{contact:?} at {}",
                        state.t
                    );
                    assert!(
                        (velocity - state.v).abs() < 1e-10 * speed,
                        "{contact:?} at {}",
                        state.t
                    );
                    assert_eq!(contact.position(state.t), depth);
                    assert_eq!(contact.velocity(state.t), velocity);
                }
            }
        }
    }

    #[test]
    fn times_near_the_ends_keep_their_relative_precision() {
        for part in [1e-300, 1e-100, 1e-30, 1e-12, 1e-6] {
            for exponent in [0.5, 1.5, 3.0, 200.0] {
                let (depth, velocity) = pulse(exponent, part);
                let linear = part * duration_factor(exponent);
                // d = v s (1 - (v s/D)^m / (2 (m + 1))).
                let loss = linear.powf(exponent + 1.0);
                assert!(
                    (depth / linear - 1.0).abs() <= loss + 1e-14,
                    "{exponent} at {part}: {depth}"
                );
                assert!((velocity - 1.0).abs() <= loss + 1e-15);
            }
        }
        for exponent in [0.5, 1.5, 3.0] {
            // y'' = -m/2 near the top, in units of D and D/v.
            let late = 1e-7;
            let (depth, velocity) = pulse(exponent, 0.5 - late);
            let expected = 0.5 * (exponent + 1.0) * late * duration_factor(exponent);
            assert!(
                (velocity / expected - 1.0).abs() < 1e-8,
                "{exponent}: {velocity} against {expected}"
            );
            assert!((1.0 - depth) < 1e-12);
        }
    }

    #[test]
    fn the_correction_of_a_spring_is_that_of_its_closed_form() {
        // d'' + a + (k + gamma) d = 0 by hand: d = c (cos w s - 1) + (v/w) sin w s, c = a/w^2.
        let (gamma, speed, a, k) = (1e4, 1.0, 3.0, 150.0);
        let w = f64::sqrt(gamma + k);
        let c = a / (w * w);
        let (depth, duration) =
            ((c * c + (speed / w).powi(2)).sqrt() - c, 2.0 / w * (speed / w).atan2(c));
        let contact = PowerLaw::new(1.0, gamma, speed).unwrap();
        let mut previous = f64::INFINITY;
        for order in 1..=HIGHEST_ORDER {
            let corrected = contact.corrected(a, k, order).unwrap();
            let errors = [corrected.depth / depth - 1.0, corrected.duration / duration - 1.0];
            assert!(
                errors[0].abs() <= corrected.depth_error
                    && errors[1].abs() <= corrected.duration_error,
                "{errors:?}"
            );
            let worst = errors[0].abs().max(errors[1].abs());
            assert!(worst < 0.2 * previous, "order {order}: {errors:?}");
            previous = worst;
        }
        assert!(previous < 1e-10, "{previous}");
    }

    #[test]
    fn every_order_of_the_correction_is_of_its_order() {
        // Halving a and k lowers the error of order N by 2^(N+1).
        for exponent in [0.5, 1.0, 1.5, 2.0, 3.0] {
            let contact = PowerLaw::new(exponent, 1e3, 1.0).unwrap();
            let scale = contact.speed / contact.depth;
            for (preload, slope) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.3, -0.5)] {
                for order in 1..=3_u32 {
                    let error = |part: f64| {
                        let (a, k) =
                            (part * preload * contact.speed * scale, part * slope * scale * scale);
                        let corrected = contact.corrected(a, k, order).unwrap();
                        let path = integrated(&contact, a, k);
                        let depth = corrected.depth / path.occurrences()[0].state.x - 1.0;
                        let duration = corrected.duration / path.end().t - 1.0;
                        assert!(
                            depth.abs() < 2.0 * corrected.depth_error + 1e-11,
                            "{exponent} {preload} {slope} {order}: {depth}"
                        );
                        assert!(
                            duration.abs() < 2.0 * corrected.duration_error + 1e-11,
                            "{exponent} {preload} {slope} {order}: {duration}"
                        );
                        (depth, duration)
                    };
                    let (coarse, fine) = (error(0.04), error(0.02));
                    for (name, coarse, fine) in
                        [("depth", coarse.0, fine.0), ("duration", coarse.1, fine.1)]
                    {
                        let slope_found = (coarse / fine).abs().log2();
                        let lowest = f64::from(order) + 0.8;
                        assert!(
                            slope_found > lowest || coarse.abs() < 2e-10,
                            "{name}, n {exponent}, a {preload}, k {slope}, order {order}: {coarse} {fine}, slope {slope_found}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn the_corrected_motion_has_its_depth_its_duration_and_nearly_its_shape() {
        for exponent in [1.0, 1.5, 2.0] {
            let contact = PowerLaw::new(exponent, 1e4, 1.0).unwrap();
            for part in [-0.1, 0.01, 0.1] {
                let preload = part * contact.speed * contact.speed / contact.depth;
                let corrected = contact.corrected(preload, 0.0, 4).unwrap();
                let path = integrated(&contact, preload, 0.0);
                let middle = corrected.phase_point_at(0.5 * corrected.duration);
                assert!((middle.0 / corrected.depth - 1.0).abs() < 1e-14 && middle.1.abs() < 1e-14);
                assert!(corrected.position(corrected.duration).abs() < 1e-15);
                let mut worst = (0.0_f64, 0.0_f64);
                for state in path.samples(201) {
                    let (depth, velocity) = corrected.phase_point_at(state.t);
                    worst.0 = worst.0.max((depth - state.x).abs() / contact.depth);
                    worst.1 = worst.1.max((velocity - state.v).abs() / contact.speed);
                }
                let allowed = corrected.shape_error();
                assert!(allowed < 0.2 * part.abs(), "{exponent}, {part}: {allowed}");
                assert!(worst.0 < allowed + 1e-6, "{exponent}, {part}: {worst:?} above {allowed}");
                assert!(
                    worst.1 < 1.5 * allowed + 1e-6,
                    "{exponent}, {part}: {worst:?} above {allowed}"
                );
                let force = preload + 1e4 * path.occurrences()[0].state.x.powf(exponent);
                assert!((corrected.peak_force() / force - 1.0).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn what_is_no_contact_is_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(PowerLaw::new(bad, 1.0, 1.0), Err(ContactError::NotPositive(_))));
            assert!(matches!(PowerLaw::new(1.0, bad, 1.0), Err(ContactError::NotPositive(_))));
            assert!(matches!(PowerLaw::new(1.0, 1.0, bad), Err(ContactError::NotPositive(_))));
        }
        let contact = PowerLaw::default();
        assert!(matches!(contact.corrected(f64::NAN, 0.0, 2), Err(ContactError::NotFinite { .. })));
        assert!(matches!(
            contact.corrected(0.0, f64::INFINITY, 2),
            Err(ContactError::NotFinite { .. })
        ));
        for order in [0, HIGHEST_ORDER + 1, u32::MAX] {
            assert!(matches!(contact.corrected(1.0, 1.0, order), Err(ContactError::Order { .. })));
        }
        let refused = PowerLaw::new(0.01, 1e300, 1e-300).unwrap_err();
        assert_eq!(refused, ContactError::Range { quantity: "depth" });
        let refused = contact.corrected(1e9, 0.0, 2).unwrap_err();
        assert!(refused.to_string().ends_with("take the exact contact"), "{refused}");
    }

    fn wild() -> impl Strategy<Value = f64> {
        prop_oneof![
            any::<f64>(),
            (-308.0..308.0_f64).prop_map(|power| 10.0_f64.powf(power)),
            (-3.0..3.0_f64).prop_map(|power| 10.0_f64.powf(power)),
        ]
    }

    proptest! {
        #[test]
        fn no_number_makes_it_panic_or_lie(
            exponent in wild(), stiffness in wild(), speed in wild(), preload in wild(), slope in wild(), time in wild(),
            order in 1..=HIGHEST_ORDER
        ) {
            if let Ok(contact) = PowerLaw::new(exponent, stiffness, speed) {
                let (depth, velocity) = contact.phase_point_at(time);
                prop_assert!((0.0..=contact.depth).contains(&depth) && velocity.abs() <= speed, "{contact:?} at {time}");
                for (preload, slope) in [(preload, slope), (-preload, slope), (0.0, 0.0)] {
                    if let Ok(corrected) = contact.corrected(preload, slope, order) {
                        let (depth, velocity) = corrected.phase_point_at(time);
                        prop_assert!(depth.is_finite() && velocity.is_finite(), "{corrected:?} at {time}");
                        prop_assert!(corrected.peak_force().is_finite() && corrected.duration > 0.0);
                    }
                }
            }
        }
    }
}

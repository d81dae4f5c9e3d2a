//! The contact that loses energy: d'' = -gamma d^n (1 + lambda d'), in closed form.
//!
//! Reference: K. H. Hunt and F. R. E. Crossley, *J. Appl. Mech.* 42 (1975) 440. In equation (7) the
//! force is (gamma + mu d') d^(3/2), so lambda = mu/gamma. In the phase plane, u = d', the
//! variables separate:
//!
//! ```text
//! u du / (1 + lambda u) = -gamma d^n dd          G(z) = z - ln(1 + z) = z^2/2 - z^3/3 + ..,   z = lambda u, m = n + 1
//! G(lambda u) = G(lambda v) (1 - (d/D)^m)        D = (m G(lambda v)/(gamma lambda^2))^(1/m)
//! G(-lambda e v) = G(lambda v)                   e the restitution: a function of lambda v alone, whatever n and gamma
//! e = 1 - (2/3) lambda v + (4/9) (lambda v)^2 - (44/135) (lambda v)^3 + ..
//! loading 1 + z = -W_-1(-exp(-1 - G)),  unloading 1 + z = -W_0(-exp(-1 - G)),    force = gamma d^n (1 + z)
//! ```
//!
//! with W Lambert's function. Neither branch is computed by W: near the deepest point, and all
//! along where lambda v is small, its argument -exp(-1 - G) has lost the digits of z, and beyond
//! G = 745 it underflows. `G(z) = z^2 (1 + psi(z))/2` is inverted by a root instead, psi by its
//! series near zero.
//!
//! ```text
//! T = (2 D/(m v)) int_0^pi (sin phi)^(2/m - 1) cos phi / r dphi,        (d/D)^m = sin^2 phi,  u = v r,  S = sqrt(2 G(lambda v))
//!   = (2 D lambda/(m S)) B(1/m, 1/2) (1 + m S^2/(12 (m + 2)) + ..)      the odd powers of S cancel between way in and way out
//! ```
//!
//! The force is never negative: on the way out 1 + z lies between 0 and 1, so this contact does not
//! pull.

use std::f64::consts::FRAC_PI_4;

use spec_math::cephes64::log1pmx;

use super::super::hertz::positive;
use super::super::lanes::{Lanes, Mask};
use super::time::{LegendrePanel, expand, invert, length};
use super::{ContactError, in_range, not_negative, within};
use crate::numeric::ode::root::find_root;

/// One contact by d'' = -gamma d^n (1 + lambda d'), touched with speed v. Made by
/// [`HuntCrossley::new`], so that all fields belong together.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct HuntCrossley {
    /// The exponent n > 0 of the force, 3/2 for Hertz.
    pub exponent: f64,
    /// The stiffness gamma: the force, an acceleration, at depth one at rest.
    pub stiffness: f64,
    /// The damping lambda = mu/gamma, not negative, time per depth.
    pub damping: f64,
    /// The speed v of touch, depth per time.
    pub speed: f64,
    /// The greatest depth D, in the unit of x.
    pub depth: f64,
    /// The duration T, in the unit of time.
    pub duration: f64,
    /// The greatest force, per unit of mass; on the way in, before the greatest depth.
    pub peak_force: f64,
    /// The depth at which the force is greatest.
    pub peak_depth: f64,
    /// The coefficient of restitution e, speed out over speed in.
    pub restitution: f64,
    /// The speed e v of release.
    pub exit_speed: f64,
    /// The energy lost, (1 - e^2) v^2/2, per unit of mass.
    pub energy_lost: f64,
    /// t(q) from the touch, q = sqrt(d/D), up to phi = pi/4.
    loading: Vec<LegendrePanel>,
    /// t(phi) from there to 3 pi/4.
    turning: Vec<LegendrePanel>,
    /// The time left to the release as a function of q.
    unloading: Vec<LegendrePanel>,
}

impl HuntCrossley {
    /// The contact of this exponent n, stiffness gamma and damping lambda, touched at this speed.
    ///
    /// # Errors
    /// [`ContactError`]: a quantity outside its domain, a depth, duration or force beyond double
    /// precision.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::HuntCrossley;
    ///
    /// // A Hertz contact with lambda v = 0.3.
    /// let contact = HuntCrossley::new(1.5, 1e6, 0.3, 1.0)?;
    /// assert!((contact.restitution - 0.832_869_792).abs() < 1e-9);
    /// assert!((contact.velocity(contact.duration) + contact.exit_speed).abs() < 1e-12);
    /// assert!(contact.peak_depth < contact.depth);
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn new(
        exponent: f64,
        stiffness: f64,
        damping: f64,
        speed: f64,
    ) -> Result<Self, ContactError> {
        let exponent = positive("exponent of the force", exponent)?;
        let stiffness = positive("stiffness gamma", stiffness)?;
        let speed = positive("speed of contact", speed)?;
        let damping = not_negative("damping lambda", damping)?;
        let x = damping * speed;
        if x > LARGEST {
            return Err(ContactError::Range { quantity: "product of damping and speed" });
        }
        let (m, inverse) = (exponent + 1.0, 1.0 / (exponent + 1.0));
        let undamped =
            (0.5 * m).powf(inverse) * speed.powf(2.0 * inverse) * stiffness.powf(-inverse);
        let depth = in_range("depth", undamped * (1.0 + excess(x)).powf(inverse))?;
        let loss = loss(x);
        let motion = PhasePlaneMotion { x, whole: signed_root(x) };

        let scale = depth / speed;
        let half_way = 0.5_f64.powf(0.5 * inverse);
        let too_damped = |error| match error {
            ContactError::NotSmooth => ContactError::TooDamped { product: x },
            other => other,
        };
        // With d = D q^2 the time element is dt = 2 q dq D/(v |r|).
        let side = |sign: f64| {
            let slowness = move |q: f64| {
                let rate = 1.0 / motion.speed_ratio(sign * remaining(q * q, m)).abs();
                Ok(rate)
            };
            expand(slowness, |q| 2.0 * q * scale, 0.0, half_way).map_err(too_damped)
        };
        let (loading, unloading) = (side(1.0)?, side(-1.0)?);
        let rate = |phi: f64| {
            let sigma = phi.cos();
            let quotient = if sigma == 0.0 {
                motion.slope_at_rest()
            } else {
                sigma / motion.speed_ratio(sigma)
            };
            Ok(2.0 * inverse * phi.sin().powf(2.0 * inverse - 1.0) * quotient)
        };
        let turning = expand(rate, |_| scale, FRAC_PI_4, 3.0 * FRAC_PI_4).map_err(too_damped)?;
        let duration = length(&loading) + length(&turning) + length(&unloading);

        let energy_lost = 0.5 * speed * loss * (2.0 - loss) * speed;
        if !energy_lost.is_finite() {
            return Err(ContactError::Range { quantity: "energy lost" });
        }
        let (peak_depth, factor) = motion.peak(exponent);
        // gamma D^n = (m v^2/2) (1 + psi)/D.
        let elastic = 0.5 * m * speed / depth * speed * (1.0 + excess(x));
        Ok(Self {
            exponent,
            stiffness,
            damping,
            speed,
            depth,
            duration: in_range("duration", duration)?,
            peak_force: in_range("peak force", elastic * factor)?,
            peak_depth: depth * peak_depth,
            restitution: 1.0 - loss,
            exit_speed: speed * restitution_of(x, loss),
            energy_lost,
            loading,
            turning,
            unloading,
        })
    }

    /// Depth and velocity at a time since touch; before and after the contact those of its ends.
    ///
    /// Good to 1e-12 of D and v.
    pub fn phase_point_at(&self, time: f64) -> (f64, f64) {
        let time = within(time, self.duration);
        let m = self.exponent + 1.0;
        let left = self.duration - time;
        let (part, sigma) = if time <= length(&self.loading) {
            let (q, _) = invert(&self.loading, time);
            (q * q, remaining(q * q, m))
        } else if left <= length(&self.unloading) {
            let (q, _) = invert(&self.unloading, left);
            (q * q, -remaining(q * q, m))
        } else {
            let (phi, _) = invert(&self.turning, time - length(&self.loading));
            (phi.sin().powf(2.0 / m), phi.cos())
        };
        (self.depth * part, self.speed * self.motion().speed_ratio(sigma))
    }

    /// The depth at a time since touch, in the unit of x.
    pub fn position(&self, time: f64) -> f64 {
        self.phase_point_at(time).0
    }

    /// The velocity at a time since touch, positive into the barrier.
    pub fn velocity(&self, time: f64) -> f64 {
        self.phase_point_at(time).1
    }

    /// Velocity and force, per unit of mass, at a depth on the way in; beyond the greatest depth
    /// those of it.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::HuntCrossley;
    ///
    /// let contact = HuntCrossley::new(1.5, 1e6, 0.3, 1.0)?;
    /// let half = 0.5 * contact.depth;
    /// let ((inwards, loading), (outwards, unloading)) = (contact.loading(half), contact.unloading(half));
    /// assert!(loading > unloading && inwards > -outwards); // the loop encloses the energy lost
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn loading(&self, depth: f64) -> (f64, f64) {
        self.at_depth(depth, 1.0)
    }

    /// Velocity and force, per unit of mass, at a depth on the way out; beyond the greatest depth
    /// those of it.
    pub fn unloading(&self, depth: f64) -> (f64, f64) {
        self.at_depth(depth, -1.0)
    }

    fn at_depth(&self, depth: f64, sign: f64) -> (f64, f64) {
        let depth = within(depth, self.depth);
        let ratio =
            self.motion().speed_ratio(sign * remaining(depth / self.depth, self.exponent + 1.0));
        let force =
            self.stiffness * depth.powf(self.exponent) * (1.0 + self.damping * self.speed * ratio);
        (self.speed * ratio, force)
    }

    fn motion(&self) -> PhasePlaneMotion {
        let x = self.damping * self.speed;
        PhasePlaneMotion { x, whole: signed_root(x) }
    }
}

/// The coefficient of restitution e, by the product lambda v of damping and speed of touch.
///
/// For small lambda v the restitution is 1 - (2/3) lambda v: within 1 % below lambda v = 0.15.
///
/// # Errors
/// [`ContactError::Negative`] for a product that is not a number or negative.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::contact::hunt_crossley::restitution;
///
/// assert!((restitution(1.0)? - 0.593_624_260).abs() < 1e-9);
/// # Ok::<(), lindstedt::impact::contact::ContactError>(())
/// ```
pub fn restitution(damping_times_speed: f64) -> Result<f64, ContactError> {
    let x = not_negative("product of damping and speed", damping_times_speed)?;
    Ok(restitution_of(x, loss(x)))
}

/// The product lambda v of damping and speed of touch at which a contact has this coefficient of
/// restitution.
///
/// # Errors
/// [`ContactError::Restitution`] for one that is not above 0 and at most 1.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::contact::hunt_crossley::{damping_for, restitution};
///
/// let wanted = 0.7;
/// let lambda = damping_for(wanted)? / 1.25; // at a speed of touch of 1.25
/// assert!((restitution(lambda * 1.25)? - wanted).abs() < 1e-14);
/// # Ok::<(), lindstedt::impact::contact::ContactError>(())
/// ```
pub fn damping_for(restitution: f64) -> Result<f64, ContactError> {
    if !(restitution > 0.0 && restitution <= 1.0) {
        return Err(ContactError::Restitution(restitution));
    }
    let loss = 1.0 - restitution;
    if loss == 0.0 {
        return Ok(0.0);
    }
    // The exit speed 1/lambda is never reached: to double precision it is, from e = 0.03 down.
    let highest = (1.0 - 4.0 * f64::EPSILON) / restitution;
    let energy = |x: f64| imbalance(x, restitution, loss);
    // The first terms of the series, e = 1/(1 + 2x/3 + 4x^3/135), err by x^4, a hundredth at x = 1.
    let quotient = loss / restitution;
    let mut near = 1.5 * quotient;
    for _ in 0..3 {
        let square = 4.0 / 135.0 * near * near;
        near -= (near * (2.0 / 3.0 + square) - quotient) / (2.0 / 3.0 + 3.0 * square);
    }
    let apart = 0.02 * near * near * near;
    if near < 1.0
        && let Ok(found) = find_root(energy, near * (1.0 - apart), near * (1.0 + apart))
    {
        return Ok(found);
    }
    match energy(highest) > 0.0 {
        true => Ok(find_root(energy, 0.0, highest)?),
        false => in_range("product of damping and speed", 1.0 / restitution),
    }
}

/// The argument beyond which the square of lambda v overflows.
const LARGEST: f64 = 1e150;

/// psi(z) = 2 (z - ln(1 + z))/z^2 - 1 = -(2/3) z + (1/2) z^2 - (2/5) z^3 + .., for z > -1.
///
/// With u = z/(2 + z), ln(1 + z) = 2 artanh u: psi = -u - u (1 - u)^2 (1/3 + u^2/5 + u^4/7 + ..),
/// nothing of which cancels.
pub(in crate::impact) fn excess(z: f64) -> f64 {
    excesses(Lanes([z])).0[0]
}

/// [`excess`] of several numbers.
#[inline(always)]
pub(in crate::impact) fn excesses<const L: usize>(z: Lanes<L>) -> Lanes<L> {
    let u = z / (2.0 + z);
    let square = u * u;
    let mut series = square.polynomial(const { odd_reciprocals::<8>() });
    let is_wide = square.is_above(Lanes::all(0.01));
    if is_wide.any() {
        series = is_wide.select(square.polynomial(const { odd_reciprocals::<17>() }), series);
    }
    let mut excess = -u - u * (1.0 - u) * (1.0 - u) * series;
    let is_far = square.is_above(Lanes::all(1.0 / 9.0));
    if is_far.any() {
        for lane in 0..L {
            if is_far.0[lane] {
                let z = z.0[lane];
                excess.0[lane] = -2.0 * (log1pmx(z) / z) / z - 1.0;
            }
        }
    }
    excess
}

/// 1/(2k + 1) from k = `N` down to 1: 8 are enough for u^2 < 0.01, and 17 for u^2 < 1/9, as 9^-18 <
/// 2^-53.
const fn odd_reciprocals<const N: usize>() -> [f64; N] {
    let mut reciprocals = [1.0; N];
    let mut k = 0;
    while k < N {
        reciprocals[k] = 1.0 / (2 * (N - k) + 1) as f64;
        k += 1;
    }
    reciprocals
}

/// The signed square root of 2 G(z), z sqrt(1 + psi(z)): increasing, and z itself near zero.
fn signed_root(z: f64) -> f64 {
    z * (1.0 + excess(z)).max(0.0).sqrt()
}

/// 2 (G(-e x) - G(x))/x^2, where the loss 1 - e is given as well, for its digits: it grows with e,
/// at the rate 2 e/(1 - e x), and has its zero at the restitution.
fn imbalance(x: f64, e: f64, loss: f64) -> f64 {
    e * e * excess(-e * x) - excess(x) - loss * (2.0 - loss)
}

/// 1 - e at lambda v = x, with all its digits however small x is.
pub(in crate::impact) fn loss(x: f64) -> f64 {
    losses(Lanes([x])).0[0]
}

/// [`loss`] of several numbers.
#[inline(always)]
pub(in crate::impact) fn losses<const L: usize>(x: Lanes<L>) -> Lanes<L> {
    /// Largest number of Newton's steps, each of which doubles the digits.
    const MOST_NEWTON: usize = 6;
    // Newton from e = 1/(1 + 2x/3 + 4x^3/135), which has the first three terms of the series and is
    // good to 1 % at x = 1.
    let constant = excesses(x);
    let excluded = x * (2.0 / 3.0 + 4.0 / 135.0 * x * x);
    let mut loss = excluded / (1.0 + excluded);
    let mut is_open = Mask([true; L]);
    for _ in 0..MOST_NEWTON {
        let e = 1.0 - loss;
        let imbalance = e * e * excesses(-e * x) - constant - loss * (2.0 - loss);
        let step = imbalance * (1.0 - e * x) / (2.0 * e);
        loss = is_open.select(loss + step, loss);
        // The remaining error is of the order of the square of the step.
        is_open = is_open.and((step * step).is_above(1e-17 * loss));
        if !is_open.any() {
            break;
        }
    }
    for lane in 0..L {
        let x = x.0[lane];
        if x < 1e-9 {
            loss.0[lane] = 2.0 / 3.0 * x;
        } else if x >= 1.0 {
            loss.0[lane] = 1.0 - restitution_of(x, 0.0);
        }
    }
    loss
}

/// e at lambda v = x, with all its digits however large x is.
fn restitution_of(x: f64, loss: f64) -> f64 {
    if x < 1.0 {
        return 1.0 - loss;
    }
    // lambda times the exit speed lies between 0.59 and 1.
    inverse_root(-signed_root(x.min(LARGEST))).abs() / x
}

/// z of S = z sqrt(1 + psi(z)): -1 - W(-exp(-1 - S^2/2)) by the branch of the sign of S.
fn inverse_root(s: f64) -> f64 {
    let series = s + s * s / 3.0;
    if s.abs() < 1e-6 {
        // The next term is S^3/36.
        return series + s * s * s / 36.0;
    }
    let margin = 1e-14;
    let late = |z: f64| signed_root(z) - s;
    if s > 0.0 {
        let (low, high) = (s * (1.0 - margin), (s + 0.5 * s * s) * (1.0 + margin));
        return find_root(late, low, high).unwrap_or(series);
    }
    let low = f64::max(s * (1.0 + margin), -1.0 + f64::EPSILON);
    if late(low) > 0.0 {
        // 1 + z = exp(-1 - G) is below the resolution of z.
        return -1.0;
    }
    find_root(late, low, 0.0).unwrap_or(series)
}

/// sqrt(1 - y^m): the part of S that is left at the depth y D.
fn remaining(y: f64, m: f64) -> f64 {
    (-(m * y.ln()).exp_m1()).max(0.0).sqrt()
}

/// The greatest force of a contact, per unit of mass, as of [`HuntCrossley::new`] but without its
/// motion in time; `None` for quantities outside their domains.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::contact::{HuntCrossley, hunt_crossley::peak_force};
///
/// let contact = HuntCrossley::new(1.5, 1e6, 0.3, 1.0)?;
/// assert_eq!(peak_force(1.5, 1e6, 0.3, 1.0), Some(contact.peak_force));
/// # Ok::<(), lindstedt::impact::contact::ContactError>(())
/// ```
pub fn peak_force(exponent: f64, stiffness: f64, damping: f64, speed: f64) -> Option<f64> {
    let x = damping * speed;
    let inside = exponent > 0.0 && stiffness > 0.0 && speed > 0.0 && (0.0..=LARGEST).contains(&x);
    if !inside {
        return None;
    }
    let (m, inverse) = (exponent + 1.0, 1.0 / (exponent + 1.0));
    let undamped = (0.5 * m).powf(inverse) * speed.powf(2.0 * inverse) * stiffness.powf(-inverse);
    let depth = undamped * (1.0 + excess(x)).powf(inverse);
    let whole = signed_root(x);
    let (_, factor) = PhasePlaneMotion { x, whole }.peak(exponent);
    Some(0.5 * m * speed / depth * speed * (1.0 + excess(x)) * factor)
        .filter(|force| force.is_finite())
}

/// The motion in the phase plane: u/v as a function of sigma, the part of S(lambda v) that is left,
/// with its sign.
#[derive(Debug, Clone, Copy)]
struct PhasePlaneMotion {
    /// lambda v.
    x: f64,
    /// S(lambda v).
    whole: f64,
}

impl PhasePlaneMotion {
    fn speed_ratio(&self, sigma: f64) -> f64 {
        if self.x < 1e-9 {
            // z = S + S^2/3 with S = sigma x (1 - x/3).
            return sigma * (1.0 + self.x / 3.0 * (sigma - 1.0));
        }
        inverse_root(sigma * self.whole) / self.x
    }

    /// sigma v/u at the greatest depth.
    fn slope_at_rest(&self) -> f64 {
        if self.x < 1e-9 { 1.0 + self.x / 3.0 } else { self.x / self.whole }
    }

    /// d/D at which the force is greatest, and the force there in units of gamma D^n.
    fn peak(&self, n: f64) -> (f64, f64) {
        let m = n + 1.0;
        // The derivative of y^n (1 + z) vanishes where z = (m/2n) S(lambda v)^2 (1 - sigma^2), and S(z) = sigma
        // S(lambda v): an equation for z, between zero and lambda v.
        let (square, factor) = (self.whole * self.whole, 0.5 * m / n);
        let late = |z: f64| z - factor * (square - z * z * (1.0 + excess(z)));
        let z = if self.x == 0.0 { 0.0 } else { find_root(late, 0.0, self.x).unwrap_or(0.0) };
        let y = match self.x == 0.0 {
            true => 1.0,
            false => (z / (factor * square)).min(1.0).powf(1.0 / m),
        };
        (y, y.powf(n) * (1.0 + z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::contact::PowerLaw;
    use crate::impact::contact::by_runge_kutta;
    use crate::impact::{Integrator, Model, Settings, Start, simulate};
    use crate::numeric::ode::Trajectory;
    use crate::numeric::ode::quadrature::integrate_smooth;
    use proptest::prelude::*;

    fn integrated(contact: &HuntCrossley) -> Trajectory {
        let HuntCrossley { exponent, stiffness, damping, speed, depth, duration, .. } = *contact;
        by_runge_kutta(
            |d, v| stiffness * d.max(0.0).powf(exponent) * (1.0 + damping * v),
            [speed, depth, 2.0 * duration],
        )
    }

    /// Restitutions from a loss of a thousandth to one of 95 %.
    const RESTITUTIONS: [f64; 8] = [0.999, 0.99, 0.9, 0.7, 0.5, 0.3, 0.1, 0.05];

    #[test]
    fn restitution_of_the_literature_and_by_its_law() {
        for (x, e) in [(0.1, 0.937_475_580), (0.3, 0.832_869_792), (1.0, 0.593_624_260)] {
            assert!((restitution(x).unwrap() - e).abs() < 6e-10, "{x}");
        }
        for power in -60..60 {
            let x = 10.0_f64.powf(f64::from(power) / 10.0);
            let e = restitution(x).unwrap();
            // lambda v (1 + e) = ln((1 + lambda v)/(1 - lambda e v)).
            if x > 0.01 && x < 8.0 {
                let law = (x.ln_1p() - (-x * e).ln_1p()) / (x * (1.0 + e));
                assert!((law - 1.0).abs() < 1e-10, "{x}: {law}");
            }
            if x < 0.01 {
                let series = 1.0 - 2.0 / 3.0 * x + 4.0 / 9.0 * x * x - 44.0 / 135.0 * x * x * x;
                assert!((e - series).abs() < x.powi(4) + 1e-15, "{x}: {e} against {series}");
                assert!((loss(x) / x - 2.0 / 3.0 + 4.0 / 9.0 * x).abs() < x * x + 1e-14);
            }
            if x > 30.0 {
                assert!((e * x - 1.0).abs() < 1e-12, "{x}: {e}");
            }
            let back = damping_for(e).unwrap();
            // For a large x the exit speed no longer tells it.
            if (1e-3..15.0).contains(&x) {
                assert!((back / x - 1.0).abs() < 1e-11, "{x}: {back}");
            }
            assert!((restitution(back).unwrap() - e).abs() < 1e-13 * e.max(x), "{x}: {back}");
        }
        // The linear law, to 1 % below 0.15 and no further.
        let linear = |x: f64| (1.0 - 2.0 / 3.0 * x) / restitution(x).unwrap() - 1.0;
        assert!(
            linear(0.15).abs() < 0.0101 && linear(0.16).abs() > 0.0101,
            "{} {}",
            linear(0.15),
            linear(0.16)
        );
        assert_eq!((restitution(0.0), damping_for(1.0)), (Ok(1.0), Ok(0.0)));
    }

    #[test]
    fn both_branches_are_those_of_lambert() {
        for power in -80..=12 {
            for sign in [1.0, -1.0] {
                let s = sign * 10.0_f64.powf(f64::from(power) / 10.0);
                let z = inverse_root(s);
                if z == -1.0 {
                    assert!((-1.0 - 0.5 * s * s).exp() < f64::EPSILON, "{s}");
                    continue;
                }
                // dz/dS = S (1 + z)/z: near -1 the digits of S are not those of z.
                let error = (signed_root(z) - s) * s * (1.0 + z) / z;
                assert!((error / z).abs() < 1e-14, "{s}: {z}");
                if (0.1..6.0).contains(&s.abs()) {
                    // w exp(w) = -exp(-1 - G), on the branch of its sign.
                    let w = -1.0 - z;
                    let product = w * w.exp() / -(-1.0 - 0.5 * s * s).exp();
                    assert!((product - 1.0).abs() < 1e-12 || s < -3.0, "{s}: {product}");
                    assert!((w < -1.0) == (s > 0.0));
                }
            }
        }
    }

    #[test]
    fn the_contact_is_that_of_runge_kutta_over_the_grid() {
        for exponent in [1.0, 1.5, 2.0, 3.0] {
            for (stiffness, speed) in [(1.0, 1.0), (1e9, 1e-6), (1e6, 10.0), (3e7, 1.3)] {
                for e in RESTITUTIONS {
                    let damping = damping_for(e).unwrap() / speed;
                    let contact = HuntCrossley::new(exponent, stiffness, damping, speed).unwrap();
                    let case = format!("n {exponent}, gamma {stiffness}, v {speed}, e {e}");
                    assert!(
                        (contact.restitution - e).abs() < 1e-12,
                        "{case}: {}",
                        contact.restitution
                    );
                    let path = integrated(&contact);
                    let deepest = path.occurrences()[0].state.x;
                    assert!(
                        (contact.depth / deepest - 1.0).abs() < 1e-10,
                        "{case}: {} against {deepest}",
                        contact.depth
                    );
                    assert!(
                        (contact.duration / path.end().t - 1.0).abs() < 1e-9,
                        "{case}: {}",
                        contact.duration
                    );
                    assert!(
                        (contact.exit_speed / -path.end().v - 1.0).abs() < 1e-8,
                        "{case}: {}",
                        contact.exit_speed
                    );
                    let mut peak = 0.0_f64;
                    for state in path.samples(401) {
                        let (depth, velocity) = contact.phase_point_at(state.t);
                        assert!(
                            (depth - state.x).abs() < 1e-9 * deepest,
                            "{case} at {}: {depth}",
                            state.t
                        );
                        assert!(
                            (velocity - state.v).abs() < 1e-9 * speed,
                            "{case} at {}: {velocity}",
                            state.t
                        );
                        assert_eq!(
                            (contact.position(state.t), contact.velocity(state.t)),
                            (depth, velocity)
                        );
                        let force =
                            stiffness * state.x.max(0.0).powf(exponent) * (1.0 + damping * state.v);
                        peak = peak.max(force);
                        let depth = state.x.clamp(0.0, contact.depth);
                        let (_, by_depth) = if state.v > 0.0 {
                            contact.loading(depth)
                        } else {
                            contact.unloading(depth)
                        };
                        // Near the greatest depth the velocity is the root of a small difference of
                        // depths.
                        assert!(
                            (by_depth - force).abs() < 1e-4 * contact.peak_force,
                            "{case} at {}: {by_depth}",
                            state.t
                        );
                    }
                    assert!(
                        (-1e-12..2e-3).contains(&(contact.peak_force / peak - 1.0)),
                        "{case}: peak {peak}"
                    );
                    let lost = 0.5 * speed * speed - 0.5 * path.end().v.powi(2);
                    assert!((contact.energy_lost / lost - 1.0).abs() < 1e-7, "{case}: {lost}");
                }
            }
        }
    }

    #[test]
    fn the_loop_of_force_and_depth_encloses_the_energy_lost() {
        for exponent in [1.0, 1.5, 3.0] {
            for e in RESTITUTIONS {
                let contact =
                    HuntCrossley::new(exponent, 1e4, damping_for(e).unwrap(), 1.0).unwrap();
                // d = D (1 - w^2): the forces are smooth in w there.
                let area = |w: f64| {
                    let depth = contact.depth * (1.0 - w * w);
                    (contact.loading(depth).1 - contact.unloading(depth).1)
                        * 2.0
                        * w
                        * contact.depth
                };
                let (enclosed, _) = integrate_smooth(area, 0.0, 1.0, 1e-10).unwrap();
                assert!(
                    (enclosed / contact.energy_lost - 1.0).abs() < 1e-7,
                    "n {exponent}, e {e}: {enclosed}"
                );
                let (velocity, force) = contact.loading(contact.peak_depth);
                assert!((force / contact.peak_force - 1.0).abs() < 1e-9 && velocity > 0.0);
                for shift in [0.99, 1.01] {
                    assert!(contact.loading(contact.peak_depth * shift).1 < contact.peak_force);
                }
            }
        }
    }

    #[test]
    fn without_damping_it_is_the_power_law_and_with_a_little_nearly() {
        for exponent in [0.5, 1.5, 3.0] {
            let law = PowerLaw::new(exponent, 1e6, 0.7).unwrap();
            for damping in [0.0, 1e-300, 1e-12, 1e-8] {
                let contact = HuntCrossley::new(exponent, 1e6, damping, 0.7).unwrap();
                assert!((contact.depth / law.depth - 1.0).abs() < damping + 1e-14);
                assert!((contact.duration / law.duration - 1.0).abs() < damping + 1e-12);
                assert!((contact.peak_force / law.peak_force - 1.0).abs() < damping + 1e-13);
                for part in 0..=20 {
                    let time = law.duration * f64::from(part) / 20.0;
                    assert!(
                        (contact.position(time) - law.position(time)).abs()
                            < (damping + 1e-12) * law.depth
                    );
                }
                let lost = contact.energy_lost / (0.5 * 0.7 * 0.7);
                let expected = 4.0 / 3.0 * damping * 0.7;
                assert!((lost - expected).abs() <= 1e-7 * expected, "{lost} against {expected}");
            }
        }
    }

    #[test]
    fn the_duration_begins_as_its_series() {
        for exponent in [1.0, 1.5, 3.0] {
            let m = exponent + 1.0;
            let missing = |x: f64| {
                let contact = HuntCrossley::new(exponent, 1e4, x, 1.0).unwrap();
                let s = signed_root(x);
                let beta = spec_math::cephes64::beta(1.0 / m, 0.5);
                let series = 2.0 * contact.depth * x / (m * s)
                    * beta
                    * (1.0 + m * s * s / (12.0 * (m + 2.0)));
                (contact.duration / series - 1.0).abs()
            };
            let order = (missing(0.4) / missing(0.2)).log2();
            assert!(
                missing(0.3) < 1e-5 && (3.5..4.5).contains(&order),
                "{exponent}: {} {order}",
                missing(0.3)
            );
        }
    }

    #[test]
    fn the_simulator_loses_as_much() {
        for e in [0.99, 0.8, 0.5, 0.2] {
            let gamma = 3e12;
            let start = Start { x: 0.323, velocity: 1.3 };
            let lambda = damping_for(e).unwrap() / start.velocity;
            let model = Model { gamma, mu: lambda * gamma, ..Model::default() };
            let settings = Settings { duration: 0.1, ..Settings::default() };
            let contact = HuntCrossley::new(1.5, gamma, lambda, start.velocity).unwrap();
            let motion = simulate(&model, start, Integrator::Taylor, &settings).unwrap();
            let impact = &motion.impacts[0];
            // Gravity does a few millionths of the work.
            assert!(
                (impact.restitution.unwrap() - e).abs() < 1e-5,
                "{e}: {:?}",
                impact.restitution
            );
            assert!((impact.penetration / contact.depth - 1.0).abs() < 1e-4);
            let duration = impact.exit_time.unwrap() - impact.entry_time;
            assert!((duration / contact.duration - 1.0).abs() < 2e-4, "{e}: {duration}");
        }
    }

    #[test]
    fn what_is_no_contact_is_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                HuntCrossley::new(bad, 1.0, 1.0, 1.0),
                Err(ContactError::NotPositive(_))
            ));
            assert!(matches!(
                HuntCrossley::new(1.5, bad, 1.0, 1.0),
                Err(ContactError::NotPositive(_))
            ));
            assert!(matches!(
                HuntCrossley::new(1.5, 1.0, 1.0, bad),
                Err(ContactError::NotPositive(_))
            ));
            assert!(matches!(damping_for(bad), Err(ContactError::Restitution(_))));
        }
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                HuntCrossley::new(1.5, 1.0, bad, 1.0),
                Err(ContactError::Negative { .. })
            ));
            assert!(restitution(bad).is_err());
        }
        assert!(damping_for(1.0 + 1e-15).is_err());
    }

    fn wild() -> impl Strategy<Value = f64> {
        prop_oneof![
            any::<f64>(),
            (-308.0..308.0_f64).prop_map(|power| 10.0_f64.powf(power)),
            (-3.0..3.0_f64).prop_map(|power| 10.0_f64.powf(power)),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn no_number_makes_it_panic_or_lie(
            exponent in wild(), stiffness in wild(), damping in wild(), speed in wild(), time in wild()
        ) {
            if let Ok(e) = restitution(damping) {
                prop_assert!((0.0..=1.0).contains(&e));
            }
            if let Ok(x) = damping_for(damping) {
                prop_assert!(x.is_finite() && x >= 0.0);
            }
            if let Ok(contact) = HuntCrossley::new(exponent, stiffness, damping, speed) {
                let (depth, velocity) = contact.phase_point_at(time);
                prop_assert!((0.0..=contact.depth * (1.0 + 1e-12)).contains(&depth), "{contact:?} at {time}");
                prop_assert!(velocity.abs() <= speed * (1.0 + 1e-9), "{contact:?} at {time}: {velocity}");
                prop_assert!((0.0..=1.0).contains(&contact.restitution) && contact.energy_lost >= 0.0);
                for (velocity, force) in [contact.loading(depth), contact.unloading(time)] {
                    prop_assert!(velocity.is_finite() && force >= 0.0, "{force}");
                }
            }
        }
    }
}

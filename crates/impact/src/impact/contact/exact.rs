//! The exact contact: any force of the depth, d'' + g(d) = 0, from touch to release.
//!
//! In: g, the whole force in contact per unit of mass, g(d) = f(x_c + d) + gamma F(d), as a
//! closure, and the speed v of touch. Out: an [`ExactContact`]: depth D, duration T, the motion,
//! which is symmetric about its middle, and its [`SineSeries`].
//!
//! ```text
//! v^2/2 = W(D),  W(d) = int_0^d g                 u(d) = sqrt(v^2 - 2 W(d)) the speed at depth d
//! T/2 = int_0^D dd/u = int 2 q dq / u             d = q^2, from the touch to half the way: roots of the depth are smooth in q
//!                    + int q h(w) dw              q = q_D (1 - w^2), from there to the deepest point, q_D = sqrt(D)
//!                                                 h = 4 q_D w / sqrt(2 G(w)), G = W(D) - W(q^2), an integral over w itself
//! d(s) = (g(0)/2) s (T - s) + sum_(k odd) b_k sin(k pi s/T)
//! b_k = (4/(k pi)) int_0^D cos(k pi t(d)/T) dd - 4 g(0) T^2/(k pi)^3
//! ```
//!
//! (L. D. Landau and E. M. Lifshitz, *Mechanics*, 3rd ed., section 11, for the time by the energy.)
//! Neither u nor h is a difference of nearly equal numbers, however slow the touch, whatever acts
//! beside the contact. Both are kept as Legendre series on panels, halved until the last
//! coefficients vanish; the time is their integral term by term, the motion its inverse by a root.
//! The parabola carries the jump of the acceleration at touch, so that b_k falls as 1/k^5 or, for
//! d^n, as 1/k^(n + 3): 16 sines are a Hertz contact to 1e-6 of its depth.
//!
//! ```
//! # use lindstedt_impact as lindstedt;
//! use lindstedt::impact::contact::ExactContact;
//!
//! // The paper's pendulum on a soft barrier: gravity is half of what turns it.
//! let contact = ExactContact::new(|d| (0.323 + d).sin() + d.powf(1.5), 0.5)?;
//! assert!((contact.phase_point_at(contact.duration).1 + 0.5).abs() < 1e-12);
//! let series = contact.sine_series(1e-6);
//! assert!(series.deviation <= 1e-6 && series.harmonics.len() == 10);
//! # Ok::<(), lindstedt::impact::contact::ContactError>(())
//! ```

use std::cell::RefCell;
use std::f64::consts::PI;

use num_complex::Complex64;

use super::super::hertz::positive;
use super::time::{LegendrePanel, expand, invert, length};
use super::{ContactError, in_range, within};
use crate::decimal::significant;
use crate::numeric::ode::quadrature::{QuadratureError, integrate_part, nodes_and_weights};
use crate::numeric::ode::root::find_root;

/// Largest number of odd, and of even, sines of a series.
const MOST_HARMONICS: usize = 64;

/// Parts of equal time in which a motion is sampled for its sines.
const PARTS: usize = 512;

/// A contact under any force of the depth. Made by [`ExactContact::new`], so that all fields belong
/// together.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ExactContact {
    /// The speed v of touch, depth per time.
    pub speed: f64,
    /// The force g(0) at touch, per unit of mass: the preload.
    pub force_at_touch: f64,
    /// The greatest depth D, in the unit of x.
    pub depth: f64,
    /// The duration T, in the unit of time.
    pub duration: f64,
    /// The greatest force, per unit of mass.
    pub peak_force: f64,
    /// t(q), from the touch on.
    first: Vec<LegendrePanel>,
    /// T/2 - t(w), from the deepest point back.
    second: Vec<LegendrePanel>,
}

impl ExactContact {
    /// The contact under this force (of the depth d >= 0, per unit of mass, positive out of the
    /// barrier), touched at this speed.
    ///
    /// Depth and duration are good to 1e-12 for a smooth force.
    ///
    /// # Errors
    /// [`ContactError`]: a speed that is not a positive number; a force that never turns the motion
    /// back, has no finite value on the way or is not smooth there; a depth or a duration beyond
    /// double precision.
    pub fn new(force: impl Fn(f64) -> f64, speed: f64) -> Result<Self, ContactError> {
        let speed = positive("speed of contact", speed)?;
        in_range("energy", speed * speed)?;
        let force_at_touch = force(0.0);
        if !force_at_touch.is_finite() {
            return Err(QuadratureError::NonFinite { at: 0.0 }.into());
        }
        let deepest = deepest_root(&force, speed)?;
        let depth = in_range("depth", deepest * deepest)?;
        let work = Running::new(|q: f64| 2.0 * q * force(q * q), 0.5 * speed * speed);
        let slowness = |q: f64| -> Result<f64, ContactError> {
            let square = speed * speed - 2.0 * work.up_to(q)?;
            match square > 0.0 {
                true => Ok(1.0 / square.sqrt()),
                false => Err(ContactError::NeverTurns { searched: q * q }),
            }
        };
        let first = expand(slowness, |q| 2.0 * q, 0.0, 0.5 * deepest)?;
        // From the deepest point back, q = Q (1 - w^2), the force gives what it took.
        let given = Running::new(
            |w: f64| {
                let q = deepest * (1.0 - w * w);
                4.0 * deepest * w * q * force(q * q)
            },
            0.0,
        );
        let rate = |w: f64| -> Result<f64, ContactError> {
            let given = given.up_to(w)?;
            match given > 0.0 {
                true => Ok(4.0 * deepest * w / (2.0 * given).sqrt()),
                false => Err(ContactError::NeverTurns { searched: depth }),
            }
        };
        let second = expand(rate, |w| deepest * (1.0 - w * w), 0.0, 0.5_f64.sqrt())?;
        let duration = in_range("duration", 2.0 * (length(&first) + length(&second)))?;
        let samples = (0..=64).map(|part| force(depth * f64::from(part) / 64.0));
        Ok(Self {
            speed,
            force_at_touch,
            depth,
            duration,
            peak_force: samples.fold(f64::NEG_INFINITY, f64::max),
            first,
            second,
        })
    }

    /// Depth and velocity at a time since touch; before and after the contact those of its ends.
    ///
    /// Good to 1e-12 of the depth and of the greatest speed.
    pub fn phase_point_at(&self, time: f64) -> (f64, f64) {
        let time = within(time, self.duration);
        let falling = time > 0.5 * self.duration;
        let since = if falling { self.duration - time } else { time };
        let (depth, speed) = if since <= length(&self.first) {
            let (q, slowness) = invert(&self.first, since);
            (q * q, 1.0 / slowness)
        } else {
            let (w, rate) = invert(&self.second, (0.5 * self.duration - time).abs());
            let shallower = 1.0 - w * w;
            (self.depth * shallower * shallower, 4.0 * self.depth.sqrt() * w / rate)
        };
        (depth, if falling { -speed } else { speed })
    }

    /// The depth at a time since touch, in the unit of x.
    pub fn position(&self, time: f64) -> f64 {
        self.phase_point_at(time).0
    }

    /// The velocity at a time since touch, positive into the barrier.
    pub fn velocity(&self, time: f64) -> f64 {
        self.phase_point_at(time).1
    }

    /// The motion as a parabola and odd sines, as many as are needed to stay within `tolerance` of
    /// D, at most 64.
    ///
    /// The remaining error is [`SineSeries::deviation`]: compare it with the tolerance.
    pub fn sine_series(&self, tolerance: f64) -> SineSeries {
        let duration = self.duration;
        let mut series = SineSeries {
            duration,
            parabola: 0.5 * self.force_at_touch,
            harmonics: vec![],
            even: vec![],
            deviation: f64::INFINITY,
        };
        // Half the contact is enough, and its middle is where the sines add up to the most.
        let times = (1..=256).map(|part| 0.5 * duration * f64::from(part) / 256.0);
        let mut left: Vec<(f64, f64)> = times
            .map(|time| (time, self.position(time) - series.parabola * time * (duration - time)))
            .collect();
        for coefficient in self.coefficients() {
            let angle = (2 * series.harmonics.len() + 1) as f64 * PI / duration;
            let mut worst = 0.0_f64;
            for (time, rest) in &mut left {
                *rest -= coefficient * (angle * *time).sin();
                worst = worst.max(rest.abs());
            }
            series.harmonics.push(coefficient);
            series.deviation = worst / self.depth;
            if series.deviation <= tolerance {
                break;
            }
        }
        series
    }

    /// b_1, b_3, .. of the series.
    fn coefficients(&self) -> Vec<f64> {
        let wave = PI / self.duration;
        let highest = (2 * MOST_HARMONICS - 1) as f64;
        let deepest = self.depth.sqrt();
        // (angle of the first harmonic, element of the depth), so dense that the highest harmonic
        // turns by no more than 6 rad in a piece.
        let mut elements: Vec<(f64, f64)> = Vec::new();
        let mut gather =
            |panels: &[LegendrePanel], angle: &dyn Fn(f64) -> f64, element: &dyn Fn(f64) -> f64| {
                for panel in panels {
                    let pieces = 1 + (highest * wave * (panel.end - panel.start) / 6.0) as usize;
                    let width = (panel.to - panel.from) / pieces as f64;
                    for piece in 0..pieces {
                        let from = panel.from + width * piece as f64;
                        for (at, weight) in nodes_and_weights(from, from + width) {
                            elements.push((wave * angle(panel.time_at(at)), weight * element(at)));
                        }
                    }
                }
            };
        gather(&self.first, &|time| time, &|q| 2.0 * q);
        gather(&self.second, &|before| 0.5 * self.duration - before, &|w| {
            4.0 * deepest * deepest * (1.0 - w * w) * w
        });
        let harmonic = |number: usize| {
            let k = (2 * number + 1) as f64;
            let sum: f64 =
                elements.iter().map(|(angle, element)| (k * angle).cos() * element).sum();
            4.0 / (k * PI) * (sum - self.force_at_touch / (k * wave) / (k * wave))
        };
        (0..MOST_HARMONICS).map(harmonic).collect()
    }
}

/// The motion of a contact in elementary functions: d(s) = parabola s (T - s) + sum_k b_k sin(k pi
/// s/T), of odd k alone where the way out mirrors the way in.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SineSeries {
    /// The duration T, in the unit of time.
    pub duration: f64,
    /// The coefficient g(0)/2 of s (T - s), depth per time squared: it carries the acceleration at
    /// touch.
    pub parabola: f64,
    /// b_1, b_3, b_5, .., in the unit of x.
    pub harmonics: Vec<f64>,
    /// b_2, b_4, b_6, .., in the unit of x; empty if nothing is lost.
    pub even: Vec<f64>,
    /// The largest difference from the motion that it was made of, relative to D.
    pub deviation: f64,
}

impl SineSeries {
    /// The series of these numbers, a motion of its own: T, the coefficient of s (T - s), and b_1,
    /// b_3, ..
    pub fn new(duration: f64, parabola: f64, harmonics: Vec<f64>) -> Self {
        Self { duration, parabola, harmonics, even: vec![], deviation: 0.0 }
    }

    /// The series of a motion from touch to release, given at any time and as deep as `depth`: as
    /// many sines as stay within `tolerance` of that, at most 64 odd and 64 even ones.
    ///
    /// `parabola` is half of the deceleration at touch and at release; with zero the series needs
    /// more sines. The remaining error is [`SineSeries::deviation`].
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::{HuntCrossley, SineSeries};
    ///
    /// let contact = HuntCrossley::new(1.5, 1e6, 0.3, 1.0)?;
    /// let series = SineSeries::from_motion(|s| contact.position(s), contact.duration, 0.0, contact.depth, 1e-6);
    /// assert!(series.deviation <= 1e-6 && (series.phase_point_at(contact.duration).1 + contact.exit_speed).abs() < 1e-3);
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn from_motion(
        position: impl Fn(f64) -> f64,
        duration: f64,
        parabola: f64,
        depth: f64,
        tolerance: f64,
    ) -> Self {
        let mut series = Self { deviation: f64::INFINITY, ..Self::new(duration, parabola, vec![]) };
        let sine = |number: usize, part: usize| {
            (PI * ((number * part) % (2 * PARTS)) as f64 / PARTS as f64).sin()
        };
        let mut left: Vec<f64> = (1..PARTS)
            .map(|part| {
                let time = duration * part as f64 / PARTS as f64;
                position(time) - parabola * time * (duration - time)
            })
            .collect();
        let is_mirrored = (1..PARTS / 2)
            .all(|part| (left[part - 1] - left[PARTS - part - 1]).abs() <= 1e-9 * depth);
        for number in 1..=2 * MOST_HARMONICS {
            if number % 2 == 0 && is_mirrored {
                continue;
            }
            // The trapezoidal rule is exact except for harmonics beyond twice the number of parts.
            let sum: f64 = (1..PARTS).map(|part| left[part - 1] * sine(number, part)).sum();
            let coefficient = 2.0 / PARTS as f64 * sum;
            for part in 1..PARTS {
                left[part - 1] -= coefficient * sine(number, part);
            }
            match number % 2 {
                0 => series.even.push(coefficient),
                _ => series.harmonics.push(coefficient),
            }
            series.deviation =
                left.iter().fold(0.0, |worst: f64, rest| worst.max(rest.abs())) / depth;
            if series.deviation <= tolerance {
                break;
            }
        }
        series
    }

    /// Number k and b_k of every sine, in the order of k.
    pub fn sines(&self) -> Vec<(u32, f64)> {
        let odd = (1..).step_by(2).zip(self.harmonics.iter().copied());
        let even = (2..).step_by(2).zip(self.even.iter().copied());
        let mut sines: Vec<(u32, f64)> = odd.chain(even).collect();
        sines.sort_by_key(|(number, _)| *number);
        sines
    }

    /// Depth and velocity at a time since touch; before and after the contact those of its ends.
    pub fn phase_point_at(&self, time: f64) -> (f64, f64) {
        let time = within(time, self.duration);
        let mut depth = self.parabola * time * (self.duration - time);
        let mut velocity = self.parabola * (self.duration - 2.0 * time);
        // exp(i k phi) of the odd k, and of the even ones, one turn by 2 phi after the other: one
        // sine and cosine for all.
        let first = PI / self.duration;
        let wave = Complex64::cis(first * time);
        let turn = wave * wave;
        let of_number = [(1, wave, &self.harmonics), (2, turn, &self.even)];
        for (lowest, mut wave, coefficients) in of_number {
            for (number, coefficient) in coefficients.iter().enumerate() {
                depth += coefficient * wave.im;
                velocity += coefficient * (2 * number + lowest) as f64 * first * wave.re;
                wave *= turn;
            }
        }
        (depth, velocity)
    }

    /// The formula in the usual form, this many significant digits: s is the time since touch.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::ExactContact;
    ///
    /// let spring = ExactContact::new(|d| 4.0 * d, 1.0)?;
    /// assert_eq!(spring.sine_series(1e-9).closed_form(6), "d(s) = 0.5 sin(2 s)");
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn closed_form(&self, digits: usize) -> String {
        let mut terms = Vec::new();
        if self.parabola != 0.0 {
            let duration = significant(self.duration, digits);
            terms.push((self.parabola, format!("s ({duration} - s)")));
        }
        for (number, coefficient) in self.sines() {
            let wave = f64::from(number) * PI / self.duration;
            terms.push((coefficient, format!("sin({} s)", significant(wave, digits))));
        }
        let mut text = "d(s) =".to_owned();
        for (number, (coefficient, function)) in terms.iter().enumerate() {
            let sign = match (*coefficient < 0.0, number) {
                (false, 0) => "",
                (true, 0) => "-",
                (false, _) => "+ ",
                (true, _) => "- ",
            };
            text += &format!(" {sign}{} {function}", significant(coefficient.abs(), digits));
        }
        text
    }
}

/// An integral from zero at rising places, each from the one before: a corner or a jump on the way
/// is met once, not by every integral beyond it. A request at a smaller place discards the values
/// beyond it: a shorter piece may resolve a jump that a longer piece had at its very end, behind
/// all points of the rule.
struct Running<F> {
    integrand: F,
    /// The size of the whole of which the integral is a part: errors count relative to it.
    whole: f64,
    /// Places in rising order, and the integral up to each.
    known: RefCell<Vec<(f64, f64)>>,
}

impl<F: Fn(f64) -> f64> Running<F> {
    fn new(integrand: F, whole: f64) -> Self {
        Self { integrand, whole, known: RefCell::default() }
    }

    fn up_to(&self, place: f64) -> Result<f64, QuadratureError> {
        let mut known = self.known.borrow_mut();
        while known.pop_if(|(known, _)| *known > place).is_some() {}
        let (from, before) = known.last().copied().unwrap_or((0.0, 0.0));
        let whole = before + integrate_part(&self.integrand, [from, place], 1e-14, self.whole)?;
        known.push((place, whole));
        Ok(whole)
    }
}

/// The work of the force up to the depth q^2, as a part of the energy that is to be taken up.
fn work(force: impl Fn(f64) -> f64, q: f64, energy: f64) -> Result<f64, QuadratureError> {
    integrate_part(|q| 2.0 * q * force(q * q), [0.0, q], 1e-14, energy)
}

/// The work by pieces in the golden section, none of which ends at the end of a panel that was
/// halved: a jump of the force beside such an end lies behind all points of a rule.
fn work_by_sections(
    force: impl Fn(f64) -> f64,
    q: f64,
    energy: f64,
) -> Result<f64, QuadratureError> {
    const PIECES: i32 = 60;
    const SECTION: f64 = 0.618_033_988_749_894_9;
    let end_of = |piece: i32| {
        if piece < PIECES { q - q * SECTION.powi(piece) } else { q }
    };
    (0..PIECES)
        .map(|piece| {
            let ends = [end_of(piece), end_of(piece + 1)];
            integrate_part(|q| 2.0 * q * force(q * q), ends, 1e-14, energy)
        })
        .sum()
}

/// The square root of the depth at which the force has first done the work v^2/2.
fn deepest_root(force: impl Fn(f64) -> f64, speed: f64) -> Result<f64, ContactError> {
    let energy = 0.5 * speed * speed;
    // A depth at which the force has no value is too deep.
    let left = |q: f64| match work(&force, q, energy) {
        Ok(work) => 1.0 - work / energy,
        Err(_) => -1.0,
    };
    let never = |q: f64| ContactError::NeverTurns { searched: q * q };
    let (mut low, mut high) = (1.0, 1.0);
    while left(low) < 0.0 {
        low *= 0.5;
        if low < 1e-150 {
            return Err(never(1.0));
        }
    }
    while left(high) > 0.0 {
        low = high;
        high *= 2.0;
        if high > 1e150 {
            return Err(never(high));
        }
    }
    let mut deepest = find_root(left, low, high)?;
    // The force may turn the motion back earlier, by a hump that the search stepped over.
    let earlier = (1..64).map(|part| deepest * f64::from(part) / 64.0).find(|&q| left(q) < 0.0);
    if let Some(beyond) = earlier {
        (low, high) = (beyond - deepest / 64.0, beyond);
        deepest = find_root(left, low, high)?;
    }
    // A jump that one way of summing the work misses is found by the other.
    let again = |q: f64| match work_by_sections(&force, q, energy) {
        Ok(work) => 1.0 - work / energy,
        Err(_) => -1.0,
    };
    if again(deepest).abs() > 1e-10 {
        deepest = find_root(again, low, high).unwrap_or(deepest);
    }
    // The edge of where the force is defined is no turning point.
    let beyond = deepest * (1.0 + 1e-9);
    match work(&force, beyond, energy) {
        // The nodes of a rule need not include a point beyond the edge.
        Ok(_) if force(beyond * beyond).is_finite() => Ok(deepest),
        _ => Err(never(deepest)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::contact::PowerLaw;
    use crate::impact::contact::by_runge_kutta;
    use crate::numeric::ode::Trajectory;
    use proptest::prelude::*;

    fn integrated(force: &dyn Fn(f64) -> f64, contact: &ExactContact) -> Trajectory {
        by_runge_kutta(|d, _| force(d), [contact.speed, contact.depth, 2.0 * contact.duration])
    }

    #[test]
    fn the_power_law_over_the_grid() {
        for exponent in [0.5, 1.0, 1.5, 2.0, 2.7, 3.0] {
            for stiffness in [1.0, 1e3, 1e6, 1e9] {
                for speed in [1e-6, 1e-3, 1.0, 10.0] {
                    let law = PowerLaw::new(exponent, stiffness, speed).unwrap();
                    let contact =
                        ExactContact::new(|d| stiffness * d.powf(exponent), speed).unwrap();
                    assert!(
                        (contact.depth / law.depth - 1.0).abs() < 1e-13,
                        "{law:?}: {}",
                        contact.depth
                    );
                    assert!(
                        (contact.duration / law.duration - 1.0).abs() < 1e-12,
                        "{law:?}: {}",
                        contact.duration
                    );
                    assert!((contact.peak_force / law.peak_force - 1.0).abs() < 1e-12);
                    for part in 0..=40 {
                        let time = law.duration * f64::from(part) / 40.0;
                        let ((depth, velocity), (expected, expected_velocity)) =
                            (contact.phase_point_at(time), law.phase_point_at(time));
                        assert!(
                            (depth - expected).abs() < 1e-12 * law.depth,
                            "{law:?} at {part}/40: {depth}"
                        );
                        assert!(
                            (velocity - expected_velocity).abs() < 4e-12 * speed,
                            "{law:?} at {part}/40: {velocity}"
                        );
                        assert_eq!(
                            (contact.position(time), contact.velocity(time)),
                            (depth, velocity)
                        );
                    }
                }
            }
        }
    }

    /// A spring whose force jumps at a depth: two pieces of sines, k (D^2 - d0^2) + 2 F (D - d0) =
    /// v^2 - k d0^2. Depth and duration are good to 1e-11 where the jump is seen by all rules, to
    /// 1e-4 at every place of this grid.
    #[test]
    fn a_jump_on_the_way_is_met_in_closed_form() {
        let (stiffness, speed) = (400.0_f64, 1.0_f64);
        let omega = stiffness.sqrt();
        let places = (0..200).map(|part| (2e-4 * f64::from(part), 1e-4)).chain([(0.02, 1e-11)]);
        for (jump_at, bound) in places {
            for jump in [1e-3, 1.0, 30.0] {
                let contact = ExactContact::new(
                    |d| stiffness * d + if d > jump_at { jump } else { 0.0 },
                    speed,
                )
                .unwrap();
                let centre = jump / stiffness;
                let whole = centre * centre + speed * speed / stiffness + 2.0 * centre * jump_at;
                let depth = whole.sqrt() - centre;
                let before = (jump_at * omega / speed).asin() / omega;
                let beyond = ((jump_at + centre) / (depth + centre)).acos() / omega;
                let relative = [
                    contact.depth / depth - 1.0,
                    contact.duration / (2.0 * (before + beyond)) - 1.0,
                ];
                assert!(
                    relative.iter().all(|error| error.abs() < bound),
                    "{jump} at {jump_at}: {relative:?}"
                );
                for part in 1..8 {
                    let time = before + beyond * f64::from(part) / 8.0;
                    let expected =
                        (depth + centre) * (omega * (before + beyond - time)).cos() - centre;
                    let (found, _) = contact.phase_point_at(time);
                    assert!(
                        (found - expected).abs() < bound * depth,
                        "{jump} at {jump_at}, {part}/8: {found} for {expected}"
                    );
                }
            }
        }
    }

    /// The pendulum at a barrier: where it stands, gamma, speed of touch, harmonics allowed for
    /// 1e-6.
    const PENDULUM: [(f64, f64, f64, usize); 9] = [
        (0.323, 1.0, 1.0, 12),
        (0.323, 1.0, 0.01, 2),
        (0.323, 3e7, 1.3, 16),
        (0.323, 1e9, 10.0, 16),
        (0.323, 1e6, 1e-6, 1),
        (-0.4, 1.0, 0.5, 14),
        (-0.4, 1.0, 1e-6, 14),
        (-0.4, 1e6, 1e-3, 12),
        (-0.4, 1e9, 2.0, 16),
    ];

    #[test]
    fn the_pendulum_on_barriers_hard_and_soft_is_that_of_runge_kutta() {
        for (barrier, stiffness, speed, _) in PENDULUM {
            let force = move |d: f64| f64::sin(barrier + d) + stiffness * d.max(0.0).powf(1.5);
            let contact = ExactContact::new(force, speed).unwrap();
            let case = format!("barrier {barrier}, gamma {stiffness}, v {speed}");
            let path = integrated(&force, &contact);
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
            let fastest =
                path.samples(201).fold(0.0_f64, |fastest, state| fastest.max(state.v.abs()));
            for state in path.samples(201) {
                let (depth, velocity) = contact.phase_point_at(state.t);
                assert!(
                    (depth - state.x).abs() < 2e-9 * deepest,
                    "{case} at {}: {depth} against {}",
                    state.t,
                    state.x
                );
                assert!(
                    (velocity - state.v).abs() < 2e-9 * fastest,
                    "{case} at {}: {velocity} against {}",
                    state.t,
                    state.v
                );
            }
            let ends = (contact.phase_point_at(0.0), contact.phase_point_at(contact.duration));
            assert!(
                ends.0.0.abs() < 1e-15 * deepest && (ends.0.1 / speed - 1.0).abs() < 1e-10,
                "{case}: {ends:?}"
            );
            assert!(
                ends.1.0.abs() < 1e-15 * deepest && (ends.1.1 / speed + 1.0).abs() < 1e-10,
                "{case}: {ends:?}"
            );
        }
    }

    #[test]
    fn a_spring_with_a_preload_is_its_closed_form() {
        for (a, stiffness, speed) in
            [(0.3, 1e4, 1.0), (-0.3, 1.0, 1e-3), (5.0, 2.0, 1e-4), (-2.0, 1e9, 1e-6)]
        {
            let contact = ExactContact::new(|d| a + stiffness * d, speed).unwrap();
            let wave = f64::sqrt(stiffness);
            let centre = a / stiffness;
            let duration = 2.0 / wave * (speed / wave).atan2(centre);
            let amplitude = centre.hypot(speed / wave);
            let depth = if a > 0.0 {
                (speed / wave).powi(2) / (amplitude + centre)
            } else {
                amplitude - centre
            };
            assert!(
                (contact.depth / depth - 1.0).abs() < 1e-12,
                "{a}: {} against {depth}",
                contact.depth
            );
            assert!(
                (contact.duration / duration - 1.0).abs() < 1e-12,
                "{a}: {} against {duration}",
                contact.duration
            );
            for part in 1..40 {
                let time = duration * f64::from(part) / 40.0;
                // c (cos w s - 1) + (v/w) sin w s, by half angles.
                let (sine, cosine) = (0.5 * wave * time).sin_cos();
                let expected = 2.0 * sine * (speed / wave * cosine - centre * sine);
                let found = contact.position(time);
                assert!(
                    (found - expected).abs() < 1e-11 * depth,
                    "{a} at {part}/40: {found} against {expected}"
                );
            }
        }
    }

    #[test]
    fn few_sines_are_the_motion_to_a_millionth() {
        for (barrier, stiffness, speed, allowed) in PENDULUM {
            let contact =
                ExactContact::new(|d| f64::sin(barrier + d) + stiffness * d.powf(1.5), speed)
                    .unwrap();
            let series = contact.sine_series(1e-6);
            let case = format!(
                "barrier {barrier}, gamma {stiffness}, v {speed}: {} harmonics",
                series.harmonics.len()
            );
            assert!(series.deviation <= 1e-6, "{case}, {} left", series.deviation);
            assert!(series.harmonics.len() <= allowed, "{case}");
            let mut worst = 0.0_f64;
            for part in 0..=777 {
                let time = contact.duration * f64::from(part) / 777.0;
                worst = worst.max((series.phase_point_at(time).0 - contact.position(time)).abs());
            }
            assert!(worst <= 1.1e-6 * contact.depth, "{case}: {}", worst / contact.depth);
            assert!(series.closed_form(9).starts_with("d(s) = "), "{}", series.closed_form(9));
        }
        // Whatever is asked for, what is left is told.
        let hertz = ExactContact::new(|d| 1e6 * d.powf(1.5), 1.0).unwrap();
        let all = hertz.sine_series(0.0);
        assert!(
            all.harmonics.len() == MOST_HARMONICS && (1e-12..1e-7).contains(&all.deviation),
            "{}",
            all.deviation
        );
        assert!(all.parabola == 0.0);
        // b_k falls as 1/k^(9/2).
        let fall = (all.harmonics[20] / all.harmonics[41]).abs().log2() / (83.0_f64 / 41.0).log2();
        assert!((fall - 4.5).abs() < 0.1, "{fall}");
    }

    #[test]
    fn what_is_no_contact_is_refused() {
        for speed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(ExactContact::new(|d| d, speed), Err(ContactError::NotPositive(_))));
        }
        assert!(matches!(ExactContact::new(|d| d, 1e-200), Err(ContactError::Range { .. })));
        for force in
            [|_: f64| 0.0, |_: f64| -1.0, |d: f64| (-d).exp(), |d: f64| (1.0 - d * d).sqrt() / 9.0]
        {
            let refused = ExactContact::new(force, 5.0).unwrap_err();
            assert!(matches!(refused, ContactError::NeverTurns { .. }), "{refused}");
        }
        assert!(ExactContact::new(|_| f64::NAN, 1.0).is_err());
        // Up to a hump it turns, over it it does not: the search finds the first place.
        let hump = |d: f64| 10.0 * (2.0 * d).sin();
        let contact = ExactContact::new(hump, 4.0).unwrap();
        assert!((10.0 * contact.depth.sin().powi(2) - 8.0).abs() < 1e-12, "{}", contact.depth);
    }

    fn wild() -> impl Strategy<Value = f64> {
        prop_oneof![
            any::<f64>(),
            (-150.0..150.0_f64).prop_map(|power| 10.0_f64.powf(power)),
            (-4.0..4.0_f64).prop_map(|power| 10.0_f64.powf(power)),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn no_number_makes_it_panic_or_lie(
            exponent in 0.01..10.0_f64, stiffness in wild(), speed in wild(), preload in wild(), time in wild()
        ) {
            for preload in [preload, -preload] {
                if let Ok(contact) = ExactContact::new(|d| preload + stiffness * d.powf(exponent), speed) {
                    let (depth, velocity) = contact.phase_point_at(time);
                    prop_assert!(depth.is_finite() && velocity.is_finite(), "{depth} {velocity}");
                    prop_assert!(depth <= contact.depth * (1.0 + 1e-9) && depth >= 0.0, "{depth} of {}", contact.depth);
                    let energy = |d: f64| preload * d + stiffness / (exponent + 1.0) * d.powf(exponent + 1.0);
                    let (kinetic, potential) = (0.5 * velocity * velocity, energy(depth));
                    let size = 0.5 * speed * speed + potential.abs();
                    let error = kinetic + potential - 0.5 * speed * speed;
                    prop_assert!(error.abs() <= 1e-8 * size || !size.is_finite(), "{error} of {size}");
                    prop_assert!(contact.sine_series(1e-3).deviation.is_finite());
                }
            }
        }
    }
}

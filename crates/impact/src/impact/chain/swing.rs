//! The free swing of the pendulum in elliptic integrals: the time from the bottom to an angle, and
//! the area in the phase plane up to there.
//!
//! ```text
//! x'^2/2 + 2 sin^2(x/2) = E = 2 m,   sin(x/2) = sqrt(m) sin phi,   x' = 2 sqrt(m) cos phi
//! time = int dx/x'  = F(phi, m)                 to the turning point K(m)
//! area = int x' dx  = 4 m (F - D)(phi, m)       to the turning point 4 (E(m) - (1 - m) K(m))
//! F = s R_F(c^2, 1 - m s^2, 1),   D = (s^3/3) R_D(c^2, 1 - m s^2, 1),   s = sin phi, c = cos phi
//! K = pi/(2 M(1, sqrt(1 - m))),   E = K (1 - m/2 - sum 2^(n-1) c_n^2)     n = 1, 2, ...
//! ```
//!
//! (DLMF 19.25.5, 19.25.13, 22.19; the symmetric integrals by duplication, 19.36; K and E by the
//! arithmetic-geometric mean M with its differences c_n, 19.8.) d(area)/dE is
//! the time: the area is the action of the stretch, which viscous damping shrinks as exp(-2 zeta
//! t).

use std::f64::consts::FRAC_PI_2;

use crate::impact::lanes::{Lanes, Mask};

/// Time and action of a stretch of the swing: both counted from the bottom, negative on the left.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Stretch {
    /// Time, in units of 1/omega.
    pub time: f64,
    /// int x' dx, in units of m g L/omega.
    pub area: f64,
}

/// An angle to be passed, counted from the bottom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SwingAngle {
    /// The angle, rad.
    pub x: f64,
    /// sin(x/2).
    half: f64,
    /// The energy of rest there, in units of m g L.
    pub energy: f64,
}

impl SwingAngle {
    /// The spot at this angle.
    pub fn new(x: f64) -> Self {
        let half = (0.5 * x).sin();
        Self { x, half, energy: 2.0 * half * half }
    }

    /// The turning point of a swing of this energy, on the side of positive angles.
    pub fn turn(energy: f64) -> Self {
        let half = (0.5 * energy.max(0.0)).sqrt().min(1.0);
        Self { x: 2.0 * half.asin(), half, energy }
    }

    /// The turning point of a swing of this energy, whose angle is known.
    pub fn at_turn(x: f64, energy: f64) -> Self {
        Self { x, half: (0.5 * energy).sqrt(), energy }
    }

    /// The mirror image on the other side.
    pub fn mirrored(&self) -> Self {
        Self { x: -self.x, half: -self.half, ..*self }
    }

    /// (sin phi, cos phi) of the swing of this energy here; 1 and 0 at its turning point and beyond
    /// it.
    pub fn phase(&self, energy: f64) -> (f64, f64) {
        let (Lanes([sine]), Lanes([cosine])) = phases(Lanes([self.half]), Lanes([energy]));
        (sine, cosine)
    }

    /// sin(x/2).
    pub fn half_sine(&self) -> f64 {
        self.half
    }
}

/// [`SwingAngle::phase`] at several places, given by sin(x/2), with several energies.
#[inline(always)]
pub(super) fn phases<const L: usize>(
    half_sine: Lanes<L>,
    energy: Lanes<L>,
) -> (Lanes<L>, Lanes<L>) {
    let left = 0.5 * energy - half_sine * half_sine;
    let inverse = 1.0 / (0.5 * energy).sqrt();
    let swings = left.is_above(Lanes::all(0.0));
    let at_turn = Lanes::all(1.0).with_sign_of(half_sine);
    let cosine = swings.select(left, Lanes::all(0.0)).sqrt() * inverse;
    (swings.select(half_sine * inverse, at_turn), swings.select(cosine, Lanes::all(0.0)))
}

/// The undamped swing of one energy, between rest and the upright position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct UndampedSwing {
    /// E, in units of m g L, from 0 to less than 2.
    pub energy: f64,
    /// The quarter of the swing from the bottom to the turning point.
    pub quarter: Stretch,
}

impl UndampedSwing {
    /// The swing of this energy.
    pub fn new(energy: f64) -> Self {
        let Stretches { time: Lanes([time]), area: Lanes([area]) } = quarters(Lanes([energy]));
        Self { energy, quarter: Stretch { time, area } }
    }

    /// The stretch from the bottom to this angle, on the way to the right; at most to the turning
    /// point.
    pub fn stretch_to(&self, spot: &SwingAngle) -> Stretch {
        let (sine, cosine) = spot.phase(self.energy);
        if cosine == 0.0 {
            return Stretch {
                time: self.quarter.time.copysign(sine),
                area: self.quarter.area.copysign(sine),
            };
        }
        let phase = (Lanes([sine]), Lanes([cosine]));
        let Stretches { time: Lanes([time]), area: Lanes([area]) } =
            stretches(Lanes([self.energy]), phase);
        Stretch { time, area }
    }
}

/// Several [stretches](Stretch).
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretches<const L: usize> {
    /// Times, in units of 1/omega.
    pub time: Lanes<L>,
    /// int x' dx, in units of m g L/omega.
    pub area: Lanes<L>,
}

/// The quarters of swings of these energies.
#[inline(always)]
pub(super) fn quarters<const L: usize>(energy: Lanes<L>) -> Stretches<L> {
    let parameter = 0.5 * energy;
    let (mut mean, mut geometric) = (Lanes::all(1.0), (1.0 - parameter).at_least(0.0).sqrt());
    let (mut sum, mut power) = (0.5 * parameter, 1.0);
    let mut is_open = Mask([true; L]);
    for _ in 0..MOST_MEANS {
        let difference = 0.5 * (mean - geometric);
        let between = (mean * geometric).sqrt();
        mean = is_open.select(0.5 * (mean + geometric), mean);
        geometric = is_open.select(between, geometric);
        sum = is_open.select(sum - power * difference * difference, sum);
        power *= 2.0;
        is_open = is_open.and(difference.is_above(Lanes::all(NEGLIGIBLE)));
        if !is_open.any() {
            break;
        }
    }
    let time = FRAC_PI_2 / mean;
    Stretches { time, area: 4.0 * time * sum }
}

/// The stretches from the bottom to these phases of swings of these energies.
#[inline(always)]
pub(super) fn stretches<const L: usize>(
    energy: Lanes<L>,
    (sine, cosine): (Lanes<L>, Lanes<L>),
) -> Stretches<L> {
    let parameter = 0.5 * energy;
    let (first, second) = symmetric_integrals(cosine * cosine, 1.0 - parameter * sine * sine);
    let time = sine * first;
    let area = 4.0 * parameter * (time - sine * sine * sine * second * (1.0 / 3.0));
    Stretches { time, area }
}

/// R_F(x, y, 1) and R_D(x, y, 1) by duplication, both at once: they share every root.
#[inline(always)]
fn symmetric_integrals<const L: usize>(x: Lanes<L>, y: Lanes<L>) -> (Lanes<L>, Lanes<L>) {
    let (mut x, mut y, mut z) = (x, y, Lanes::all(1.0));
    let (mut sum, mut power) = (Lanes::all(0.0), Lanes::all(1.0));
    let mut is_open = Mask([true; L]);
    // Each step divides the distances of the three arguments by four; the terms left out are of the
    // sixth order in these distances.
    for _ in 0..MOST_DUPLICATIONS {
        let (a, b, c) = (x.sqrt(), y.sqrt(), z.sqrt());
        let shift = a * (b + c) + b * c;
        sum = is_open.select(sum + power / (c * (z + shift)), sum);
        power = is_open.select(0.25 * power, power);
        x = is_open.select(0.25 * (x + shift), x);
        y = is_open.select(0.25 * (y + shift), y);
        z = is_open.select(0.25 * (z + shift), z);
        let close = CLOSE * (x + y + z);
        let far = |distance: Lanes<L>| distance.abs().is_above(close);
        is_open = is_open.and(far(x - y).or(far(y - z)).or(far(z - x)));
        if !is_open.any() {
            break;
        }
    }
    let mean = (x + y + z) * (1.0 / 3.0);
    let inverse = 1.0 / mean;
    let (u, v) = (1.0 - x * inverse, 1.0 - y * inverse);
    let w = -u - v;
    let (second, third) = (u * v - w * w, u * v * w);
    let inner = second * (1.0 / 24.0) - 0.1 - (3.0 / 44.0) * third;
    let first = (1.0 + second * inner + third * (1.0 / 14.0)) / mean.sqrt();
    let mean = (x + y + 3.0 * z) * 0.2;
    let inverse = 1.0 / mean;
    let (u, v) = (1.0 - x * inverse, 1.0 - y * inverse);
    let w = -(u + v) * (1.0 / 3.0);
    let product = u * v;
    let second = product - 6.0 * w * w;
    let third = (3.0 * product - 8.0 * w * w) * w;
    let fourth = 3.0 * (product - w * w) * w * w;
    let fifth = product * w * w * w;
    let series = 1.0 - (3.0 / 14.0) * second + (1.0 / 6.0) * third + (9.0 / 88.0) * second * second
        - (3.0 / 22.0) * fourth
        - (9.0 / 52.0) * second * third
        + (3.0 / 26.0) * fifth;
    (first, power * series / (mean * mean.sqrt()) + 3.0 * sum)
}

/// Largest number of arithmetic-geometric means: enough for every m that a double below 1 can be.
const MOST_MEANS: usize = 8;

/// Half the difference of two means after which the next are equal to rounding: each is the square of
/// the one before, over four times the mean.
const NEGLIGIBLE: f64 = 1e-8;

/// Relative distance of the arguments, over their sum, below which the series are used: a deviation
/// of 0.03 from their mean leaves an error of 1e-9.
const CLOSE: f64 = 0.015;

/// Largest number of duplications, more than any argument needs: 4^-40 is below the resolution of a
/// double.
const MOST_DUPLICATIONS: usize = 40;

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use ellip::{ellipe, ellipeinc, ellipf, ellipk};

    #[test]
    fn the_stretches_are_elliptic_integrals() {
        for amplitude in [1e-6, 0.01, 0.3, 1.0, 1.5, 2.5, 3.1, 3.13] {
            let swing = UndampedSwing::new(SwingAngle::new(amplitude).energy);
            let m = 0.5 * swing.energy;
            let (first, second) = (ellipk(m).unwrap(), ellipe(m).unwrap());
            assert!((swing.quarter.time / first - 1.0).abs() < 1e-13, "{amplitude}");
            let area = 4.0 * (second - (1.0 - m) * first);
            assert!((swing.quarter.area - area).abs() < 1e-14, "{amplitude}");
            for part in [-0.999_999, -0.6, -0.1, 1e-9, 0.2, 0.5, 0.9, 0.999] {
                let x: f64 = part * amplitude;
                let phi = ((0.5 * x).sin() / m.sqrt()).asin();
                let found = swing.stretch_to(&SwingAngle::new(x));
                let time = ellipf(phi, m).unwrap();
                let area = 4.0 * (ellipeinc(phi, m).unwrap() - (1.0 - m) * time);
                assert!(
                    (found.time / time - 1.0).abs() < 1e-9,
                    "{amplitude} {part}: {} {time}",
                    found.time
                );
                assert!(
                    // The difference that the reference is has lost the digits of a small area.
                    (found.area - area).abs() < 1e-9 * m + 1e-15,
                    "{amplitude} {part}: {} {area}",
                    found.area
                );
            }
        }
    }

    #[test]
    fn a_small_swing_keeps_the_digits_of_its_area() {
        for amplitude in [1e-12, 1e-7, 1e-4] {
            let swing = UndampedSwing::new(SwingAngle::new(amplitude).energy);
            let m = 0.5 * swing.energy;
            assert!(
                (swing.quarter.area / (PI * m * (1.0 + 0.125 * m)) - 1.0).abs() < 1e-14,
                "{amplitude}"
            );
        }
    }

    #[test]
    fn the_area_grows_with_the_energy_as_the_time() {
        for (amplitude, x) in [(1.5, 0.323), (0.5, -0.2), (2.9, 1.0), (1.0, 2.0)] {
            let energy = SwingAngle::new(amplitude).energy;
            let step = 1e-5 * energy;
            let [below, above] = [energy - step, energy + step]
                .map(|energy| UndampedSwing::new(energy).stretch_to(&SwingAngle::new(x)).area);
            let time = UndampedSwing::new(energy).stretch_to(&SwingAngle::new(x)).time;
            assert!(((above - below) / (2.0 * step) / time - 1.0).abs() < 1e-7, "{amplitude} {x}");
        }
    }
}

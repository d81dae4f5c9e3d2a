//! The free swing of the pendulum in elliptic integrals: the time from the bottom to an angle, and
//! the area in the phase plane up to there.
//!
//! ```text
//! x'^2/2 + 2 sin^2(x/2) = E = 2 m,   sin(x/2) = sqrt(m) sin phi,   x' = 2 sqrt(m) cos phi
//! time = int dx/x'  = F(phi, m)                 to the turning point K(m)
//! area = int x' dx  = 4 m (F - D)(phi, m)       to the turning point 4 (E(m) - (1 - m) K(m))
//! F = s R_F(c^2, 1 - m s^2, 1),   D = (s^3/3) R_D(c^2, 1 - m s^2, 1),   s = sin phi, c = cos phi
//! ```
//!
//! (DLMF 19.25.5, 19.25.13, 22.19; the symmetric integrals by duplication, 19.36.) d(area)/dE is
//! the time: the area is the action of the stretch, which viscous damping shrinks as exp(-2 zeta
//! t).

use std::f64::consts::PI;

use spec_math::cephes64::{ellpe, ellpk};

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

    /// The mirror image on the other side.
    pub fn mirrored(&self) -> Self {
        Self { x: -self.x, half: -self.half, ..*self }
    }

    /// (sin phi, cos phi) of the swing of this energy here; 1 and 0 at its turning point and beyond
    /// it.
    pub fn phase(&self, energy: f64) -> (f64, f64) {
        let left = 0.5 * energy - self.half * self.half;
        if left <= 0.0 {
            return (1.0_f64.copysign(self.half), 0.0);
        }
        let scale = (0.5 * energy).sqrt();
        (self.half / scale, left.sqrt() / scale)
    }
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
        let parameter = 0.5 * energy;
        let time = ellpk(1.0 - parameter);
        let area = match parameter < SMALL {
            // The difference loses its digits for small m: it is computed as pi m 2F1(1/2, 1/2; 2;
            // m) (DLMF 19.5.1, 19.5.2).
            true => {
                let series = 1.0
                    + parameter * (0.125 + parameter * (3.0 / 64.0 + parameter * 25.0 / 1024.0));
                PI * parameter * series
            }
            false => 4.0 * (ellpe(parameter) - (1.0 - parameter) * time),
        };
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
        let parameter = 0.5 * self.energy;
        let (first, second) = symmetric_integrals(cosine * cosine, 1.0 - parameter * sine * sine);
        let time = sine * first;
        Stretch { time, area: 4.0 * parameter * (time - sine * sine * sine * second / 3.0) }
    }
}

/// R_F(x, y, 1) and R_D(x, y, 1) by duplication, both at once: they share every root.
fn symmetric_integrals(x: f64, y: f64) -> (f64, f64) {
    let (mut x, mut y, mut z) = (x, y, 1.0_f64);
    let (mut sum, mut power) = (0.0, 1.0);
    // Each step divides the distances of the three arguments by four; the terms left out are of the
    // sixth order in these distances.
    for _ in 0..MOST_DUPLICATIONS {
        let (a, b, c) = (x.sqrt(), y.sqrt(), z.sqrt());
        let shift = a * (b + c) + b * c;
        sum += power / (c * (z + shift));
        power *= 0.25;
        (x, y, z) = (0.25 * (x + shift), 0.25 * (y + shift), 0.25 * (z + shift));
        let spread = (x - y).abs().max((y - z).abs()).max((z - x).abs());
        if spread < CLOSE * (x + y + z) {
            break;
        }
    }
    let mean = (x + y + z) / 3.0;
    let (u, v) = (1.0 - x / mean, 1.0 - y / mean);
    let w = -u - v;
    let (second, third) = (u * v - w * w, u * v * w);
    let first =
        (1.0 + second * (second / 24.0 - 0.1 - 3.0 * third / 44.0) + third / 14.0) / mean.sqrt();
    let mean = (x + y + 3.0 * z) / 5.0;
    let (u, v) = (1.0 - x / mean, 1.0 - y / mean);
    let w = -(u + v) / 3.0;
    let product = u * v;
    let second = product - 6.0 * w * w;
    let third = (3.0 * product - 8.0 * w * w) * w;
    let fourth = 3.0 * (product - w * w) * w * w;
    let fifth = product * w * w * w;
    let series = 1.0 - 3.0 * second / 14.0 + third / 6.0 + 9.0 * second * second / 88.0
        - 3.0 * fourth / 22.0
        - 9.0 * second * third / 52.0
        + 3.0 * fifth / 26.0;
    (first, power * series / (mean * mean.sqrt()) + 3.0 * sum)
}

/// Value of m below which the area of a quarter is computed by a series, whose first term left out
/// is 0.015 m^4.
const SMALL: f64 = 1e-3;

/// Relative distance of the arguments, over their sum, below which the series are used: a deviation
/// of 0.03 from their mean leaves an error of 1e-9.
const CLOSE: f64 = 0.015;

/// Largest number of duplications, more than any argument needs: 4^-40 is below the resolution of a
/// double.
const MOST_DUPLICATIONS: usize = 40;

#[cfg(test)]
mod tests {
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
        let [below, above] =
            [SMALL.next_down(), SMALL].map(|m| UndampedSwing::new(2.0 * m).quarter.area);
        assert!((below / above - 1.0).abs() < 1e-12, "{below} {above}");
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

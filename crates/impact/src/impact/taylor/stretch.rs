//! The variable of a step: time, or s, transformed so that the singularities that limit the series
//! lie further away.
//!
//! ```text
//! dt = unit (1 + p r + q r^2) dr  in flight,   ds = unit (1 + p r + q r^2) dr  in contact
//! flight:   poles of the pendulum above and below each passage of x = 0, in complex t
//! contact:  w'' = -(5/2) w^4 (Hertz; w, w' <= 1; s from 0 to 2.507 = 2 B(1/5, 1/2)/5): where w is infinite,
//!           at 1.550 e^(i pi (2k+1)/5) from the touch, and the same seen from the release; the nearest two at 1.254 +- 0.911 i
//! ```
//!
//! A series converges up to the nearest of them. A cubic polynomial t(r) or s(r) can move several
//! of them outwards at once: the coefficients below are fits to those with which a step of the
//! tolerance 1e-10 is longest at each position. In contact that is up to 1.5 times as far, in
//! flight up to 1.6. They affect only the length of the steps: the series are those of the equation
//! in any variable, and a step is as long as its own coefficients allow.

use super::series::{Inputs, LaneSeries};

/// p and q of the steps of free flight.
#[inline(always)]
pub(super) fn in_flight<const L: usize>(inputs: &Inputs<L>) -> [[f64; L]; 2] {
    let Inputs { velocity, sine, unit, .. } = inputs;
    let [mut p, mut q] = [[0.0; L]; 2];
    for lane in 0..L {
        let speed = unit[lane] * velocity[lane];
        p[lane] = 0.15 * sine[lane] * speed;
        q[lane] = 0.021 * unit[lane] * unit[lane] + 0.06 * speed * speed;
    }
    [p, q]
}

/// p and q of the steps in contact.
#[inline(always)]
pub(super) fn in_contact<const L: usize>(inputs: &Inputs<L>) -> [[f64; L]; 2] {
    let Inputs { place: root, velocity, unit, hertz: [largest, fastest], .. } = inputs;
    let [mut p, mut q] = [[0.0; L]; 2];
    for lane in 0..L {
        // r in units of the contact of Hertz. If other forces dominate, its poles are not those of
        // the motion.
        let units = unit[lane] * fastest[lane] / largest[lane];
        let fits = units <= 2.0;
        let (w, v) = (root[lane] / largest[lane], velocity[lane] / fastest[lane]);
        let (w, v) = (if w < 1.0 { w } else { 1.0 }, if v < 1.0 { v } else { 1.0 });
        let v = if v > -1.0 { v } else { -1.0 };
        // The position in s: -1 at the touch, 0 at the greatest depth, 1 at the release.
        let place = -v * (1.0 - 0.8 * w + 0.12 * (w * w) * (w * w) * w);
        let inside = (1.0 - place * place) * (1.0 - place * place);
        p[lane] = if fits { 0.64 * place * inside * units } else { 0.0 };
        q[lane] = if fits { 0.15 * inside * units * units } else { 0.0 };
    }
    [p, q]
}

/// The coefficient n of (1 + p r + q r^2) times a series.
#[inline(always)]
pub(super) fn stretched<const L: usize>(
    [p, q]: &[[f64; L]; 2],
    series: &LaneSeries<L>,
    n: usize,
) -> [f64; L] {
    let mut result = series[n];
    if n > 0 {
        let before = if n > 1 { series[n - 2] } else { [0.0; L] };
        for lane in 0..L {
            result[lane] += p[lane] * series[n - 1][lane] + q[lane] * before[lane];
        }
    }
    result
}

/// The next coefficient of a stretched series that is not stored: from its coefficient n and the
/// two before it, the last one first.
#[inline(always)]
pub(super) fn stretched_next<const L: usize>(
    [p, q]: &[[f64; L]; 2],
    next: [f64; L],
    before: &mut [[f64; L]; 2],
) -> [f64; L] {
    let mut result = next;
    for lane in 0..L {
        result[lane] += p[lane] * before[0][lane] + q[lane] * before[1][lane];
    }
    *before = [next, before[0]];
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No state and no parameter makes a step go backwards: 1 + p r + q r^2 >= 0 for every r.
    #[test]
    fn a_stretched_step_goes_forward() {
        let numbers = [0.0, 1e-300, 1e-3, 0.3, 0.7, 1.0, 40.0, 1e300, f64::INFINITY];
        for place in numbers {
            for (speed, unit) in
                numbers.into_iter().flat_map(|speed| numbers.map(|unit| (speed, unit)))
            {
                for velocity in [speed, -speed] {
                    for (largest, fastest) in
                        [(0.0, 0.0), (1.0, 1.0), (0.1, 1e-9), (1e-9, 3.0), (f64::INFINITY, 1.0)]
                    {
                        let inputs = Inputs::<1> {
                            place: [place],
                            velocity: [velocity],
                            sine: [velocity.signum()],
                            unit: [unit],
                            hertz: [[largest], [fastest]],
                            ..Inputs::new()
                        };
                        let [[p], [q]] = in_contact(&inputs);
                        assert!(p * p <= 4.0 * q, "contact: {p} {q}");
                        if (unit * speed).abs() <= 1.0 && unit <= 1.0 {
                            let [[p], [q]] = in_flight(&inputs);
                            assert!(p * p <= 4.0 * q, "flight: {p} {q}");
                        }
                    }
                }
            }
        }
    }
}

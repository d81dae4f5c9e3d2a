//! Driven motions whose disturbances grow by many orders of magnitude in a period, as those of a
//! pendulum that is kept upright, by multiple shooting.
//!
//! ```text
//! s_i: position and velocity at the time i T/m,   P_i: the motion over the part i of the period
//! P_i(s_i) - s_(i+1) = 0,   i = 0 to m - 1,   s_m = s_0:       M_i ds_i - ds_(i+1) = -(P_i(s_i) - s_(i+1))
//! M = M_(m-1) ... M_0:   the multipliers from tr M and det M = det M_(m-1) ... det M_0
//! ```
//!
//! A single shot carries an error of the last digit of its start to the end of the period, multiplied
//! by the largest multiplier; the parts of a period multiply it by a hundred or so each (U. M. Ascher, R. M. M.
//! Mattheij, R. D. Russell, *Numerical Solution of Boundary Value Problems for Ordinary Differential
//! Equations*, SIAM 1995, chapter 4). In: a motion near the true one, and how much disturbances
//! grow. Out: the true motion with its multipliers. A step of Newton's method costs a period with its
//! variations, and linear equations of 2 m unknowns.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, Matrix2};

use super::driven::{Driven, TimedStart};
use super::jump::positions_from;
use super::stability::{FAR, Floquet, SAMPLES, TrueMotion, convergence_test};
use crate::system::Path;

/// The factor by which disturbances may grow in a part of the period, and the largest number of
/// parts.
const GROWTH: f64 = 10.0;
const MOST_PARTS: usize = 64;

/// A part of a period, with its time at the start, position and velocity at the end, and M_i.
struct Part {
    path: Path,
    begin: f64,
    end: [f64; 2],
    monodromy: Matrix2<f64>,
}

/// The true motion near one that is given by position and velocity at a phase, and of about this
/// size, if disturbances of it grow by this factor in a period; `None` if Newton's method does not
/// converge, or moves far away, or the equation has no Taylor series.
///
/// Newton's method is tried again with the shortest parts if it does not converge with as few as the growth
/// asks for. The motion that is given is then far from the true one, as a sum of too few harmonics is: over
/// shorter parts the way is more nearly linear in the starts, and they may move farther.
pub(super) fn motion_in_parts(
    driven: &Driven,
    at: (f64, f64),
    growth: f64,
    motion: impl Fn(f64) -> [f64; 2],
) -> Option<TrueMotion> {
    /// The farthest that a start may move where the parts are short, in units of the size.
    const FARTHER: f64 = 1.0;
    if !(growth > GROWTH && growth.is_finite()) {
        return None;
    }
    let wanted = (growth.ln() / GROWTH.ln()).ceil() as usize;
    let count = wanted.next_power_of_two().min(MOST_PARTS);
    motion_in(driven, at, (count, FAR), &motion)
        .or_else(|| motion_in(driven, at, (MOST_PARTS, FARTHER), &motion))
}

/// The true motion by so many parts, whose starts move by this much at most, in units of the size.
fn motion_in(
    driven: &Driven,
    (parameter, size): (f64, f64),
    (count, farthest): (usize, f64),
    motion: &impl Fn(f64) -> [f64; 2],
) -> Option<TrueMotion> {
    const MOST: usize = 20;
    /// The longest step, in units of the size: a longer one is shortened.
    const LONGEST: f64 = 0.5;
    let omega = driven.frequency_at(parameter);
    let guess: Vec<[f64; 2]> = (0..count).map(|i| motion(TAU * i as f64 / count as f64)).collect();
    let sizes = [size, size * omega];
    let mut starts = guess.clone();
    let mut settled = convergence_test(1e-9);
    for _ in 0..MOST {
        let parts = followed(driven, parameter, &starts)?;
        let next = |part: usize| (part + 1) % count;
        let mut matrix = DMatrix::zeros(2 * count, 2 * count);
        let mut missed = DVector::zeros(2 * count);
        for (i, part) in parts.iter().enumerate() {
            for row in 0..2 {
                missed[2 * i + row] = (part.end[row] - starts[next(i)][row]) / sizes[row];
                matrix[(2 * i + row, 2 * next(i) + row)] -= 1.0;
                for column in 0..2 {
                    let slope = part.monodromy[(row, column)] * sizes[column] / sizes[row];
                    matrix[(2 * i + row, 2 * i + column)] += slope;
                }
            }
        }
        let step = matrix.lu().solve(&missed)?;
        let moved = step.amax();
        if settled(missed.amax(), moved) {
            return Some(whole(&parts, starts[0], omega));
        }
        let shorter = f64::min(1.0, LONGEST / moved);
        for (i, start) in starts.iter_mut().enumerate() {
            for row in 0..2 {
                start[row] -= shorter * step[2 * i + row] * sizes[row];
                let apart = (start[row] - guess[i][row]).abs();
                if apart.is_nan() || apart > farthest * sizes[row] {
                    return None;
                }
            }
        }
    }
    None
}

/// The parts of a period from these starts; `None` if one of them cannot be followed.
fn followed(driven: &Driven, parameter: f64, starts: &[[f64; 2]]) -> Option<Vec<Part>> {
    let duration = TAU / driven.frequency_at(parameter) / starts.len() as f64;
    let motion = |(part, start): (usize, &[f64; 2])| TimedStart {
        start: *start,
        begin: part as f64 * duration,
        parameter,
        duration,
    };
    let motions: Vec<TimedStart> = starts.iter().enumerate().map(motion).collect();
    let part = |(path, motion): (Option<Path>, &TimedStart)| {
        let path = path?;
        let [x, v, variations @ ..]: [f64; 6] = path.states_at(path.end())?.try_into().ok()?;
        let monodromy = Matrix2::from_column_slice(&variations);
        Some(Part { path, begin: motion.begin, end: [x, v], monodromy })
    };
    driven.varied_by_series(&motions).into_iter().zip(&motions).map(part).collect()
}

/// The motion made of these parts.
fn whole(parts: &[Part], start: [f64; 2], frequency: f64) -> TrueMotion {
    let product = parts.iter().fold(Matrix2::identity(), |product, part| part.monodromy * product);
    let determinant: f64 = parts.iter().map(|part| part.monodromy.determinant()).product();
    // The determinant of the product itself would be lost in rounding: a matrix with the same
    // multipliers has it as an entry.
    let monodromy = Matrix2::new(0.0, -determinant, 1.0, product.trace());
    let floquet = Floquet { monodromy, self_excited: false };
    let samples = |part: &Part| positions_from(&part.path, part.begin, SAMPLES / parts.len());
    let positions: Vec<f64> = parts.iter().flat_map(samples).collect();
    TrueMotion::new(start, frequency, floquet, &positions, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::{PreparedRequest, ResponseRequest, respond};
    use crate::verify::Verdict;

    /// `x'' + c x' - x = F cos(w t)` in closed form: amplitude `F/|1 + w^2 - i c w|`, multipliers
    /// `exp(r T)` with `r^2 + c r - 1 = 0`, the larger of which is 1e26 at w = 0.1.
    #[test]
    fn a_motion_on_a_hilltop_is_judged() {
        let question = ResponseRequest::new("x'' + x'/10 - x = cos(w*t)/10", "w", [0.1, 0.4], "")
            .expect("one");
        let response = respond(&question).expect("a response");
        assert_eq!((response.verdict, response.unjudged), (Verdict::Pass, 0));
        let points = &response.branches[0].points;
        assert!(
            points[0].parameter == 0.1 && points.iter().all(|point| point.stable == Some(false))
        );
        for point in points {
            let w = point.parameter;
            let amplitude = 0.1 / (1.0 + w * w).hypot(0.1 * w);
            assert!((point.amplitude / amplitude - 1.0).abs() < 1e-9, "{point:?}");
            let root = 1.0025_f64.sqrt();
            for (found, rate) in point.multipliers.expect("two").iter().zip([root, -root]) {
                let exact = (rate - 0.05) * TAU / w;
                assert!((found.norm().ln() / exact - 1.0).abs() < 1e-8, "{point:?}");
            }
        }
    }

    /// A pendulum upright for three periods of the drive comes back to itself: far from the linear
    /// motion Newton's method takes several steps.
    #[test]
    fn a_motion_that_is_no_sum_of_few_waves_closes() {
        let question =
            ResponseRequest::new("x'' + x'/10 + sin(x) = cos(w*t)/2", "w", [0.2, 1.0], "")
                .expect("one");
        let asked = PreparedRequest::new(&question, question.equations.oscillator().expect("one"))
            .expect("a request");
        // From a crude guess of x = pi + u, u'' + u'/10 - sin(u) = cos(w t)/2.
        let w = 0.3;
        let guess = |theta: f64| {
            let a = -0.5 / (1.0 + w * w);
            [std::f64::consts::PI + a * theta.cos(), -a * w * theta.sin()]
        };
        let found = motion_in_parts(&asked.driven, (w, 0.5), 1e9, guess).expect("a motion");
        assert!(found.floquet.largest() > 1e7, "{found:?}");
        let product = found.floquet.monodromy.determinant();
        assert!((product / (-0.1 * TAU / w).exp() - 1.0).abs() < 1e-9, "{found:?}");
        assert!((found.start[0] - std::f64::consts::PI + 0.49).abs() < 0.05, "{found:?}");
    }
}

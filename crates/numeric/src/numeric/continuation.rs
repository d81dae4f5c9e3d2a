//! Branches of solutions, followed step by step: prediction along the tangent, correction by
//! Newton's method, and step lengths that adapt to the branch.
//!
//! ```text
//! F(u) = 0,  n equations for n + 1 unknowns:      [F_u; t^T] du = -[F; 0]     Newton's method at right angles to the tangent t
//!                                                 [F_u; t^T] t' = [0; 1]      the tangent that goes on the same way
//! ```
//!
//! References: H. B. Keller, in *Applications of Bifurcation Theory*, Academic Press 1977; E. L.
//! Allgower, K. Georg, *Introduction to Numerical Continuation Methods*, SIAM 2003, chapters 2 and
//! 6. Folds are no obstacle, since the branch is parametrised by its arc length, not by one of the
//!   unknowns.

use nalgebra::allocator::Allocator;
use nalgebra::{DMatrix, DVector, DefaultAllocator, Dim, Dyn, LU, OVector};

/// The result of one continuation step.
#[derive(Clone, Debug, PartialEq)]
pub enum ContinuationStep<Point, End> {
    /// The next point, and the ratio of the next step to this one.
    Taken(Point, f64),
    /// The step failed, and is repeated with half its length.
    TooLong,
    /// The end of the branch, with its last point if that is not the one before.
    Ended(Option<Point>, End),
}

/// Returns the points of a branch from `first` on, and its end. `step` takes a step from the last
/// of the points, of a length that it may shorten; `length` is the first length and `longest` the
/// largest, in the unit of the caller.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::continuation::{ContinuationStep, bordered, follow, tangent};
/// use lindstedt::numeric::ode::newton::{Progress, newton};
/// use nalgebra::{DMatrix, DVector};
///
/// // Once around the circle x^2 + y^2 = 1.
/// let vector = |x: f64, y: f64| DVector::from_vec(vec![x, y]);
/// let slopes = |at: &DVector<f64>| DMatrix::from_row_slice(1, 2, &[2.0 * at[0], 2.0 * at[1]]);
/// let step = |points: &[(DVector<f64>, DVector<f64>)], length: &mut f64| {
///     let (here, along) = &points[points.len() - 1];
///     let guess = here + along * *length;
///     let equations = |at: &DVector<f64>| {
///         let residual = vector(at.norm_squared() - 1.0, along.dot(&(at - &guess)));
///         Some((residual, bordered(&slopes(at), along)))
///     };
///     let judged = |_: &DVector<f64>, step: &DVector<f64>| match step.norm() < 1e-12 {
///         true => Progress::Settled,
///         false => Progress::Going,
///     };
///     let found = newton(guess.clone(), 5, equations, judged);
///     match found.and_then(|at| Some((tangent(&bordered(&slopes(&at), along).lu())?, at))) {
///         None => ContinuationStep::TooLong,
///         Some((_, at)) if here[1] < 0.0 && at[1] >= 0.0 => ContinuationStep::Ended(Some((at, along.clone())), "around"),
///         Some((along, at)) => ContinuationStep::Taken((at, along), 1.4),
///     }
/// };
/// let (points, end) = follow((vector(1.0, 0.0), vector(0.0, 1.0)), 0.01, 0.3, step);
/// assert!(end == "around" && points.iter().all(|(at, _)| (at.norm() - 1.0).abs() < 1e-12));
/// ```
pub fn follow<Point, End>(
    first: Point,
    mut length: f64,
    longest: f64,
    mut step: impl FnMut(&[Point], &mut f64) -> ContinuationStep<Point, End>,
) -> (Vec<Point>, End) {
    let mut points = vec![first];
    loop {
        match step(&points, &mut length) {
            ContinuationStep::Taken(point, ratio) => {
                points.push(point);
                length = longest.min(ratio * length);
            }
            ContinuationStep::TooLong => length *= 0.5,
            ContinuationStep::Ended(last, end) => {
                points.extend(last);
                return (points, end);
            }
        }
    }
}

/// Returns the motions at parts of an amplitude up to all of it, followed from a linear motion in
/// eighths, and in shorter steps where `near` finds no motion at a part, or one that is not near its
/// guess. `linear` has the unknowns of the linear motion at a part, `unknowns` those of a motion; the
/// last of them changes with the square of the amplitude at first, the others in proportion to it.
///
/// # Errors
/// The part that was reached.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::continuation::in_amplitude;
/// use nalgebra::DVector;
///
/// // omega^2 = 1 + 3 a^2/4 at a = 2.
/// let linear = |part: f64| DVector::from_vec(vec![part, 1.0]);
/// let near = |_: DVector<f64>, part: f64| Some(DVector::from_vec(vec![part, 1.0 + 3.0 * part * part]));
/// let found = in_amplitude(linear, near, |motion| motion)?;
/// assert_eq!(found.last().map(|(part, motion)| (*part, motion[1])), Some((1.0, 4.0)));
/// # Ok::<(), f64>(())
/// ```
pub fn in_amplitude<Motion>(
    linear: impl Fn(f64) -> DVector<f64>,
    mut near: impl FnMut(DVector<f64>, f64) -> Option<Motion>,
    unknowns: impl Fn(&Motion) -> &DVector<f64>,
) -> Result<Vec<(f64, Motion)>, f64> {
    /// The longest step, the ratio of two steps, and the shortest as a part of the amplitude reached.
    const LONGEST: f64 = 0.125;
    const RATIO: f64 = 2.0;
    const SHORTEST: f64 = 1e-3;
    const FIRST_AT_LEAST: f64 = 1e-5;
    const MOST: usize = 400;
    /// The largest share of a step by which the motion may miss its guess: one farther away may be of
    /// another branch.
    const SHARE: f64 = 0.05;
    /// The share of the motion itself by which it may miss its guess in any case.
    const SHARE_OF_ALL: f64 = 0.005;
    /// The share by which the last unknown may miss its guess, and the most that it may change in a step.
    const SHARE_OF_LAST: f64 = 0.25;
    /// The share for the first motion, which has to be nearly linear for its direction to be known.
    const SHARE_OF_FIRST: f64 = 0.05;
    let mut known: Vec<(f64, Motion)> = Vec::new();
    let mut step = LONGEST;
    let mut reached = 0.0_f64;
    for _ in 0..MOST {
        // Whole multiples of the step, so that parts are halves of each other where steps are equal.
        let next = (reached + step).min(1.0);
        let guess = match known.as_slice() {
            [.., (a, first), (b, second), (c, third)] => {
                // The parabola through the last three.
                let weight = |x: f64, y: f64, z: f64| (next - y) * (next - z) / ((x - y) * (x - z));
                unknowns(first) * weight(*a, *b, *c)
                    + unknowns(second) * weight(*b, *a, *c)
                    + unknowns(third) * weight(*c, *a, *b)
            }
            [(before, first), (last, second)] => {
                let part = (next - last) / (last - before);
                let (first, second) = (unknowns(first), unknowns(second));
                second + (second - first) * part
            }
            [(last, motion)] => {
                let known = unknowns(motion);
                let mut guess = known + linear(next) - linear(*last);
                let index = guess.len() - 1;
                let changed = known[index] - linear(*last)[index];
                guess[index] += changed * ((next / last).powi(2) - 1.0);
                guess
            }
            [] => linear(next),
        };
        let is_near = |motion: &Motion| {
            let found = unknowns(motion);
            let last = found.len() - 1;
            let missed = (found - &guess).rows(0, last).norm();
            let size = found.rows(0, last).norm();
            let before = known.last().map_or(found[last], |(_, before)| unknowns(before)[last]);
            let from_guess = (found[last] - guess[last]).abs() / guess[last].abs();
            let from_before = (found[last] / before).abs().ln().abs();
            if from_guess.max(from_before) > SHARE_OF_LAST {
                return false;
            }
            missed
                <= match known.last() {
                    Some((_, before)) => {
                        let moved = (found - unknowns(before)).rows(0, last).norm();
                        (SHARE * moved).max(SHARE_OF_ALL * size)
                    }
                    None => SHARE_OF_FIRST * size,
                }
        };
        match near(guess.clone(), next).filter(is_near) {
            Some(motion) => {
                known.push((next, motion));
                reached = next;
                if reached >= 1.0 {
                    return Ok(known);
                }
                step = LONGEST.min(RATIO * step);
            }
            None => {
                step /= RATIO;
                if step < SHORTEST * reached || step < FIRST_AT_LEAST {
                    return Err(reached);
                }
            }
        }
    }
    Err(reached)
}

/// Returns the Jacobian of n equations for n + 1 unknowns, bordered with `row` as its last row.
pub fn bordered(jacobian: &DMatrix<f64>, row: &DVector<f64>) -> DMatrix<f64> {
    let count = jacobian.nrows();
    DMatrix::from_fn(count + 1, count + 1, |i, j| if i < count { jacobian[(i, j)] } else { row[j] })
}

/// Returns a tangent of the branch, not normalised, from the factors of the bordered Jacobian;
/// `None` if that is singular.
pub fn tangent(factors: &LU<f64, Dyn, Dyn>) -> Option<DVector<f64>> {
    let mut right = DVector::zeros(factors.lu_internal().nrows());
    let last = right.len() - 1;
    right[last] = 1.0;
    factors.solve(&right)
}

/// Returns the sign of a determinant, which itself may be beyond doubles, from the factors of the
/// matrix.
pub fn sign_of_determinant(factors: &LU<f64, Dyn, Dyn>) -> f64 {
    let upper = factors.u();
    let negative = upper.diagonal().iter().filter(|entry| **entry < 0.0).count();
    let sign: f64 = factors.p().determinant();
    if negative % 2 == 1 { -sign } else { sign }
}

/// Whether the straight line from one point to the next passes close to a third one in between.
pub fn passes<D: Dim>(
    target: &OVector<f64, D>,
    from: &OVector<f64, D>,
    to: &OVector<f64, D>,
) -> bool
where
    DefaultAllocator: Allocator<D>,
{
    let (way, offset) = (to - from, target - from);
    let length = way.norm();
    let along = offset.dot(&way) / length;
    let across = (offset.norm_squared() - along * along).max(0.0).sqrt();
    (0.0..=length).contains(&along) && across < 0.1 * length
}

//! Newton's method for a square system of equations.
//!
//! In: a start, the residual of the equations with its Jacobian, and a judgement of each step. Out:
//! the solution, or `None`.
//!
//! ```
//! # use lindstedt_numeric as lindstedt;
//! use lindstedt::numeric::ode::newton::{Progress, newton};
//! use nalgebra::{Matrix2, Vector2};
//!
//! // The circle x^2 + y^2 = 2 and the line x = y.
//! let equations = |at: &Vector2<f64>| {
//!     let residual = Vector2::new(at.norm_squared() - 2.0, at[0] - at[1]);
//!     Some((residual, Matrix2::new(2.0 * at[0], 2.0 * at[1], 1.0, -1.0)))
//! };
//! let judged = |_: &Vector2<f64>, step: &Vector2<f64>| match step.norm() < 1e-12 {
//!     true => Progress::Settled,
//!     false => Progress::Going,
//! };
//! let solution = newton(Vector2::new(2.0, 0.5), 20, equations, judged).ok_or("none")?;
//! assert!((solution - Vector2::new(1.0, 1.0)).norm() < 1e-12);
//! # Ok::<(), &str>(())
//! ```

use nalgebra::allocator::Allocator;
use nalgebra::{DefaultAllocator, DimMin, OMatrix, OVector};

/// The judgement of a step of Newton's method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Progress {
    /// The step was so short that its end is the solution.
    Settled,
    /// The iteration continues.
    Going,
    /// The step leads away from every solution that is looked for.
    Lost,
}

/// Solves equations by at most this many steps of Newton's method from a start. `equations` returns
/// the residual and its Jacobian at a point; `judged` is called with the end of each step and the
/// step that was subtracted. Returns `None` if the equations have no value, their Jacobian is
/// singular, or the steps do not converge.
pub fn newton<D>(
    start: OVector<f64, D>,
    most: usize,
    mut equations: impl FnMut(&OVector<f64, D>) -> Option<(OVector<f64, D>, OMatrix<f64, D, D>)>,
    mut judged: impl FnMut(&OVector<f64, D>, &OVector<f64, D>) -> Progress,
) -> Option<OVector<f64, D>>
where
    D: DimMin<D, Output = D>,
    DefaultAllocator: Allocator<D> + Allocator<D, D>,
{
    let mut place = start;
    for _ in 0..most {
        let (residual, jacobian) = equations(&place)?;
        let step = jacobian.lu().solve(&residual)?;
        place -= &step;
        match judged(&place, &step) {
            Progress::Settled => return Some(place),
            Progress::Going => {}
            Progress::Lost => return None,
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn a_solution_is_found_or_there_is_none() {
        // x^2 = c
        let root = |c: f64, start: f64, most: usize| {
            let equations = |x: &DVector<f64>| {
                let value = x.map(|x| x * x - c);
                Some((value, DMatrix::from_diagonal(&(2.0 * x))))
            };
            let judged =
                |x: &DVector<f64>, step: &DVector<f64>| match step.amax() <= 1e-14 * x.amax() {
                    true => Progress::Settled,
                    false if x[0] > 1e3 => Progress::Lost,
                    false => Progress::Going,
                };
            newton(DVector::from_element(1, start), most, equations, judged).map(|x| x[0])
        };
        assert!(root(2.0, 1.0, 20).is_some_and(|x| (x - 2.0_f64.sqrt()).abs() < 1e-15));
        for (reason, none) in [
            ("too few steps", root(2.0, 1.0, 3)),
            ("no root", root(-1.0, 0.3, 20)),
            ("no inverse", root(2.0, 0.0, 20)),
            ("lost", root(2.0, 1e-5, 20)),
        ] {
            assert_eq!(none, None, "{reason}");
        }
    }
}

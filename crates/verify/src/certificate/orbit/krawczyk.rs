//! Interval Newton on the equations of the impacts, in the form of Krawczyk.
//!
//! ```text
//! |B F(X)|_i + sum_j |1 - B DF(box)|_ij r_j < r_i  for all i      box = {x: |x_i - X_i| <= r_i}
//! ```
//!
//! Then the map `1 - B F` takes the box into its interior and contracts there: F has exactly one zero in
//! it. B may be any matrix; it is the inverse of the derivative at X in doubles.
//!
//! In: phases and speeds of the impacts, and radii. Out: the radii of a smaller box that contains the zero.
//! It costs the cube of the number of unknowns in products.
//!
//! Source: R. Krawczyk: Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken, Computing 4
//! (1969), 187-201.

use nalgebra::DMatrix;

use super::OrbitNotProved;
use super::equations::{GapEquations, ImpactBalls, Linearised};
use crate::certificate::fourier_series::WORKING;
use crate::exact::Rational;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::rational::from_f64;

/// The radii of the phases and of the speeds, alike for all impacts of an orbit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Radii {
    pub(super) phase: Bound,
    pub(super) speed: Bound,
}

impl Radii {
    /// Bounds of the claims for phases and speeds.
    pub(super) fn of([phase, speed]: &[Rational; 2]) -> Self {
        Self { phase: Bound::of_fraction(phase), speed: Bound::of_fraction(speed) }
    }

    /// The radii in the order of the unknowns: phase and speed in turn.
    fn of_unknown(self, index: usize) -> Bound {
        if index.is_multiple_of(2) { self.phase } else { self.speed }
    }
}

/// The impacts with these radii.
pub(super) fn widened(impacts: &[ImpactBalls], radii: Radii) -> Vec<ImpactBalls> {
    let wide = |ball: &Ball, radius: Bound| Ball { radius, ..ball.clone() };
    let impact = |own: &ImpactBalls| ImpactBalls {
        wall: own.wall,
        phase: wide(&own.phase, radii.phase),
        speed: wide(&own.speed, radii.speed),
    };
    impacts.iter().map(impact).collect()
}

/// The inverse of the derivative in doubles, exact as balls.
///
/// # Errors
/// [`OrbitNotProved::Singular`].
fn approximate_inverse(derivative: &[Vec<Ball>]) -> Result<Vec<Vec<Ball>>, OrbitNotProved> {
    let size = derivative.len();
    let entry = |row: usize, column: usize| WORKING.nearest(&derivative[row][column]);
    let inverse = DMatrix::from_fn(size, size, entry).try_inverse();
    let inverse = inverse.ok_or(OrbitNotProved::Singular)?;
    let exact = |row: usize, column: usize| {
        from_f64(inverse[(row, column)]).map(|value| WORKING.fraction(&value))
    };
    let rows = (0..size).map(|row| (0..size).map(|column| exact(row, column)).collect());
    rows.collect::<Option<_>>().ok_or(OrbitNotProved::Singular)
}

fn scalar_product<'a>(left: &[Ball], right: impl Iterator<Item = &'a Ball>) -> Ball {
    let products = left.iter().zip(right).map(|(one, other)| WORKING.product(one, other));
    products.fold(Ball::zero(), |sum, term| WORKING.sum(&sum, &term))
}

/// The equations about approximate impacts.
pub(super) struct NewtonStep<'a> {
    equations: &'a GapEquations,
    impacts: &'a [ImpactBalls],
    turn: &'a Ball,
    inverse: Vec<Vec<Ball>>,
    /// `B F(X)`.
    pub(super) step: Vec<Ball>,
}

impl<'a> NewtonStep<'a> {
    /// Evaluates the equations at impacts without radii.
    ///
    /// # Errors
    /// [`OrbitNotProved`] if the derivative has no inverse in doubles, or numbers are too large.
    pub(super) fn new(
        equations: &'a GapEquations,
        impacts: &'a [ImpactBalls],
        turn: &'a Ball,
    ) -> Result<Self, OrbitNotProved> {
        let Linearised { residual, derivative } = equations.linearised(impacts, turn)?;
        let inverse = approximate_inverse(&derivative)?;
        let step = inverse.iter().map(|row| scalar_product(row, residual.iter())).collect();
        Ok(Self { equations, impacts, turn, inverse, step })
    }

    /// The radii of the zero, of which there is exactly one within `radii`.
    ///
    /// # Errors
    /// [`OrbitNotProved::Singular`] if the derivative may be singular within them,
    /// [`OrbitNotProved::Missed`] if the zero may lie beyond them.
    pub(super) fn within(&self, radii: Radii) -> Result<Radii, OrbitNotProved> {
        let Linearised { derivative, .. } =
            self.equations.linearised(&widened(self.impacts, radii), self.turn)?;
        let mut proved = Radii { phase: Bound::ZERO, speed: Bound::ZERO };
        for (row, inverse) in self.inverse.iter().enumerate() {
            let distance = |column: usize| {
                let image = scalar_product(inverse, derivative.iter().map(|own| &own[column]));
                let unit = WORKING.integer(i64::from(row == column));
                WORKING.magnitude(&WORKING.difference(&unit, &image)) * radii.of_unknown(column)
            };
            let spread: Bound = (0..derivative.len()).map(distance).sum();
            let whole = WORKING.magnitude(&self.step[row]) + spread;
            let limit = radii.of_unknown(row);
            let (contracts, is_inside) = (spread < limit, whole < limit);
            if !contracts {
                return Err(OrbitNotProved::Singular);
            }
            if !is_inside {
                return Err(OrbitNotProved::Missed);
            }
            match row.is_multiple_of(2) {
                true => proved.phase = proved.phase.max(whole),
                false => proved.speed = proved.speed.max(whole),
            }
        }
        Ok(proved)
    }
}

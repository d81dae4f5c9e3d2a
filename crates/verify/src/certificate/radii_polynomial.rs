//! The radii polynomial: from bounds on an approximate zero to the ball in which there is exactly
//! one.
//!
//! ```text
//! Y0 >= ||B F||,   Z1 >= ||1 - B DF||,   Z2 >= Lipschitz constant of B DF within R
//! Z2 r^2/2 - (1 - Z1) r + Y0 <= 0:       D = (1 - Z1)^2 - 2 Y0 Z2,   r = 2 Y0/((1 - Z1) + sqrt(D))
//! ```
//!
//! If `Z1 < 1`, `D > 0`, `r <= R` and `Z1 + Z2 r < 1`, the map `1 - B F` takes the ball of radius r
//! about the approximation into itself and contracts there: it has exactly one fixed point in it,
//! which is a zero of F where B is injective.
//!
//! Source: A. Hungria, J.-P. Lessard, J. D. Mireles James: Rigorous numerics for analytic solutions
//! of differential equations: the radii polynomial approach, Mathematics of Computation 85 (2016),
//! 1427-1459.

use std::fmt;

use super::force::NoValue;
use crate::decimal::rounded_up;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::expr::ExprError;

/// The result of a proof: there is exactly one motion within the radius of the approximate one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Proof {
    /// `r`: `sigma |1/omega^2 - mu| + sum |difference of the harmonics|` is at most this.
    pub radius: Bound,
    /// Y0, the norm of the residual of the approximation after the approximate inverse.
    pub defect: Bound,
    /// Z1, the norm of the identity minus the approximate inverse times the derivative.
    pub contraction: Bound,
    /// The Lipschitz constant Z2.
    pub curvature: Bound,
}

/// The inequality that does not hold. This says nothing about the motion: a larger block, or more
/// digits, may prove it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum NotProved {
    /// The force, or one of its derivatives, has no value over cosine series.
    NoValue(String),
    /// A derivative of the force is too large to be written.
    Derivative(ExprError),
    /// The motion is said to have odd harmonics alone, and the force is not odd, or the
    /// approximation has others.
    NotOdd,
    /// `Z1 >= 1`: the block does not hold enough harmonics.
    NoContraction(Bound),
    /// `D <= 0`: the approximation is too far from fulfilling the equation.
    TooFar(Bound),
    /// The radius is beyond that on which Z2 was computed, or so large that the motion might be at
    /// rest or of another period.
    TooLarge(Bound),
}

impl fmt::Display for NotProved {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::NoValue(part) => write!(
                formatter,
                "`{part}` has no value on a whole ball of motions: no convergent series was found for it"
            ),
            Self::Derivative(error) => write!(formatter, "the derivatives of the force: {error}"),
            Self::NotOdd => {
                formatter.write_str("the equation is not odd, or there are even harmonics")
            }
            Self::NoContraction(bound) => {
                write!(formatter, "Z1 <= {} is not below 1", rounded_up(bound.value(), 4))
            }
            Self::TooFar(bound) => {
                write!(formatter, "Y0 <= {} is too large", rounded_up(bound.value(), 4))
            }
            Self::TooLarge(bound) => {
                write!(formatter, "the radius {} is too large", rounded_up(bound.value(), 4))
            }
        }
    }
}

impl From<NoValue> for NotProved {
    fn from(part: NoValue) -> Self {
        Self::NoValue(part.0)
    }
}

impl From<ExprError> for NotProved {
    fn from(error: ExprError) -> Self {
        Self::Derivative(error)
    }
}

/// A step of Newton's iteration with the approximate inverse, `B F`.
pub(super) struct Correction<Place> {
    /// Corrections of the number, and of the harmonics of the block.
    pub(super) block: Vec<Ball>,
    /// Corrections of the harmonics beyond it, with their indices.
    pub(super) beyond: Vec<(Place, Ball)>,
}

/// The radius of the ball, from the bounds Y0 and Z1 and a function that gives Z2 for each R that
/// is tried. `distinct` says whether a ball of a given radius contains only motions of the required
/// kind.
///
/// # Errors
/// [`NotProved`].
pub(super) fn radius(
    defect: Bound,
    contraction: Bound,
    curvature: impl Fn(Bound) -> Result<Bound, NotProved>,
    distinct: impl Fn(Bound) -> bool,
) -> Result<Proof, NotProved> {
    let left = contraction.below_complement();
    if left <= 0.0 {
        return Err(NotProved::NoContraction(contraction));
    }
    let smallest = (defect + defect).over(left);
    let mut reason = NotProved::TooFar(defect);
    for wider in [1.05, 8.0, 64.0] {
        let within = smallest * Bound::exactly(wider);
        let curvature = curvature(within)?;
        // D >= (1 - Z1)^2 - 2 Y0 Z2.
        let discriminant =
            ((left * left).next_down() - ((defect + defect) * curvature).value()).next_down();
        if discriminant <= 0.0 {
            continue;
        }
        let divisor = (left + discriminant.sqrt().next_down()).next_down();
        let radius = (defect + defect).over(divisor);
        let contracts = (contraction + curvature * radius) < Bound::exactly(1.0);
        if radius <= within && contracts && distinct(radius) {
            return Ok(Proof { radius, defect, contraction, curvature });
        }
        reason = NotProved::TooLarge(radius);
    }
    Err(reason)
}

//! Floquet multipliers of an impact orbit from the trace and the determinant of its monodromy.
//!
//! The flow over a leg is Phi; an impact maps what deviates from the orbit by the saltation matrix
//!
//! ```text
//! (y, y') -> ((-e, 0), (-(1 + e) f/v, -e)) (y, y'),   f = the force on the gap at the impact
//! ```
//!
//! for the velocity there is -v before and e v after, and the damping in `a+ + e a-` cancels
//! (P. C. Muller, *Chaos, Solitons and Fractals* 5, 1671-1681 (1995)). So, for one impact,
//! `trace = -2 e C - (1 + e) S f/v` and `determinant = e^2 exp(-c T)`.

use num_complex::Complex64;

/// Whether neighbouring motions approach an orbit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OrbitStability {
    /// All multipliers lie within the unit circle.
    Stable,
    /// A multiplier lies on the unit circle, none outside of it: the linear terms do not decide.
    Marginal,
    /// A multiplier lies outside the unit circle.
    Unstable,
}

impl OrbitStability {
    /// The stability that multipliers tell.
    pub fn from_multipliers(multipliers: &[Complex64; 2]) -> Self {
        const MARGIN: f64 = 1e-9;
        match multipliers.iter().map(|multiplier| multiplier.norm()).fold(0.0, f64::max) {
            largest if largest < 1.0 - MARGIN => Self::Stable,
            largest if largest <= 1.0 + MARGIN => Self::Marginal,
            _ => Self::Unstable,
        }
    }

    /// The name: `stable`, `marginal` or `unstable`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Marginal => "marginal",
            Self::Unstable => "unstable",
        }
    }
}

/// Both multipliers of a monodromy, the one of larger size first.
pub(super) fn multipliers(trace: f64, determinant: f64) -> [Complex64; 2] {
    let half = 0.5 * trace;
    let square = half * half - determinant;
    if square < 0.0 {
        let root = (-square).sqrt();
        return [Complex64::new(half, root), Complex64::new(half, -root)];
    }
    // The smaller one by the product, which does not cancel.
    let large = half + half.signum() * square.sqrt();
    let small = if large == 0.0 { 0.0 } else { determinant / large };
    [large, small].map(Complex64::from)
}

/// The product of two matrices by rows.
pub(super) fn product(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let cell = |row: usize, column: usize| a[row][0] * b[0][column] + a[row][1] * b[1][column];
    [[cell(0, 0), cell(0, 1)], [cell(1, 0), cell(1, 1)]]
}

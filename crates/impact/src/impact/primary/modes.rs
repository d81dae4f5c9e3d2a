//! The two damped modes of pendulum and main mass for small swings.
//!
//! ```text
//! M z'' + C z' + K z = F,   z = (x, y),   M = [[1, 1], [1, R + 1]],   C = diag(2 zeta, delta),   K = diag(1, kappa)
//! (s^2 + 2 zeta s + 1)((R + 1) s^2 + delta s + kappa) - s^4 = 0        two pairs s, s* of roots
//! phi = (s^2, -(s^2 + 2 zeta s + 1))                                   the shape of a root
//! q = phi (M (s z + z') + C z)/m,   q' = s q + phi F/m,   m = phi (2 s M + C) phi,   z = 2 Re(q_1 phi_1 + q_2 phi_2)
//! ```
//!
//! The matrices are symmetric, so that each shape is its own left eigenvector. In: a
//! [`PrimaryCase`]. Out: [`DampedModes`], once for all flights of a motion.
//!
//! (L. Meirovitch, *Fundamentals of Vibrations*, 2001, chapter 4, for the state-space modes.)

use nalgebra::{Complex, Matrix4};

use super::{PrimaryCase, PrimaryError};
use crate::impact::chain::{ChainError, MOST_DAMPING};

/// A mode: a root, its shape and its weight.
#[derive(Clone, Copy, Debug)]
pub(super) struct DampedMode {
    /// s, with a positive imaginary part.
    pub root: Complex<f64>,
    /// phi, in x and in y.
    pub shape: [Complex<f64>; 2],
    /// phi/m, by which a force enters.
    pub projection: [Complex<f64>; 2],
}

/// Both modes with the numbers of the matrices.
#[derive(Clone, Copy, Debug)]
pub(super) struct DampedModes {
    pub modes: [DampedMode; 2],
    /// R + 1.
    pub whole: f64,
    /// 2 zeta and delta.
    damping: [f64; 2],
    stiffness: f64,
}

impl DampedModes {
    /// The modes of a case.
    ///
    /// # Errors
    /// [`ChainError`]: too much damping for a slow decay, or two modes that coincide.
    pub(super) fn new(case: &PrimaryCase) -> Result<Self, PrimaryError> {
        let (primary, zeta) = (&case.primary, case.model.zeta);
        let (r, delta, kappa) = (primary.mass, primary.damping, primary.stiffness);
        let (whole, double) = (r + 1.0, 2.0 * zeta);
        if zeta >= MOST_DAMPING {
            return Err(ChainError::Overdamped(zeta).into());
        }
        let share = 0.5 * delta / (kappa * r).sqrt();
        if share >= MOST_DAMPING {
            return Err(ChainError::OverdampedMainMass(share).into());
        }
        // x'' and y'' by the inverse of M, whose determinant is R.
        #[rustfmt::skip]
        let first_order = Matrix4::new(
            0.0, 0.0, 1.0, 0.0,
            0.0, 0.0, 0.0, 1.0,
            -whole / r, kappa / r, -whole * double / r, delta / r,
            1.0 / r, -kappa / r, double / r, -delta / r,
        );
        let found = first_order.complex_eigenvalues();
        let polynomial = [
            kappa,
            double * kappa + delta,
            kappa + double * delta + whole,
            delta + double * whole,
            r,
        ];
        let mut roots =
            found.iter().filter(|root| root.im > 0.0).map(|root| polished(&polynomial, *root));
        let (Some(one), Some(other), None) = (roots.next(), roots.next(), roots.next()) else {
            return Err(ChainError::OverdampedMainMass(share).into());
        };
        if (one - other).norm() < CLOSEST * one.norm() {
            return Err(ChainError::EqualModes.into());
        }
        let mode = |root: Complex<f64>| {
            let square = root * root;
            let shape = [square, -(square + root * double + 1.0)];
            let [x, y] = shape;
            let weight = (root * 2.0 + double) * x * x
                + root * x * y * 4.0
                + (root * (2.0 * whole) + delta) * y * y;
            DampedMode { root, shape, projection: [x / weight, y / weight] }
        };
        let (slow, fast) = if one.norm() < other.norm() { (one, other) } else { (other, one) };
        Ok(Self {
            modes: [mode(slow), mode(fast)],
            whole,
            damping: [double, delta],
            stiffness: kappa,
        })
    }

    /// The amplitudes q of a state: z and z'.
    pub(super) fn amplitudes(&self, z: [f64; 2], rate: [f64; 2]) -> [Complex<f64>; 2] {
        self.modes.map(|mode| {
            let [x, y] = [0, 1].map(|index| mode.root * z[index] + rate[index]);
            let [p, q] = mode.projection;
            p * (x + y + self.damping[0] * z[0]) + q * (x + y * self.whole + self.damping[1] * z[1])
        })
    }

    /// z of the steady answer z exp(s t) to a force F exp(s t).
    pub(super) fn response(&self, s: Complex<f64>, [x, y]: [Complex<f64>; 2]) -> [Complex<f64>; 2] {
        let square = s * s;
        let first = square + s * self.damping[0] + 1.0;
        let second = square * self.whole + s * self.damping[1] + self.stiffness;
        let determinant = first * second - square * square;
        [(second * x - square * y) / determinant, (first * y - square * x) / determinant]
    }
}

/// A root after two of Newton's steps, which leave it as exact as the polynomial; the coefficients
/// begin with the constant.
fn polished(polynomial: &[f64; 5], mut root: Complex<f64>) -> Complex<f64> {
    for _ in 0..2 {
        let zero = Complex::new(0.0, 0.0);
        let (value, slope) = polynomial
            .iter()
            .rev()
            .fold((zero, zero), |(value, slope), own| (value * root + *own, slope * root + value));
        let step = value / slope;
        if step.norm() < 1e-3 * root.norm() {
            root -= step;
        }
    }
    root
}

/// The least distance of two roots, in parts of their size: below it their shapes are the same to
/// half of the digits.
const CLOSEST: f64 = 1e-6;

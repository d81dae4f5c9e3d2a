//! The amplitude beyond which steady motions of slow equations are those of the truncation:
//! spurious ones.
//!
//! ```text
//! S_0(a) = omega a,     S_k(a) = the sum of the sizes of all terms of the k-th order, of degree two and above in the amplitude
//! ```
//!
//! The series is of use as long as each order is much smaller than the one before. Where the last
//! one is more than half of that, a steady motion balances what was kept against what was left out,
//! and says nothing of the equation. The degrees nought and one are there at every amplitude, such
//! as a shift of the linear frequency, and do not count. Whether a true motion is near such a
//! steady motion is for verification to find out.

use super::Solution;
use super::plane::PlanePolynomial;
use super::response::Plane;
use crate::symbol::Symbol;

/// Slow equations by their orders, with numbers.
pub(super) struct Orders {
    /// The rates of each order of each part of the slow equations.
    parts: Vec<Vec<[PlanePolynomial; 2]>>,
    /// The angular frequency of the motion.
    frequency: f64,
}

impl Orders {
    /// `None` if a value is missing.
    pub(super) fn new(
        solution: &Solution,
        plane: &Plane,
        frequency: f64,
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Option<Self> {
        let numeric = |rate| PlanePolynomial::new(solution, rate, plane.coordinates, value_of);
        let parts = plane.parts.iter().map(|part| {
            let orders = part.iter().map(|[u, v]| Some([numeric(u)?, numeric(v)?]));
            orders.collect::<Option<Vec<_>>>()
        });
        Some(Self { parts: parts.collect::<Option<_>>()?, frequency })
    }

    /// Whether at this amplitude the last order is more than half of the one before it.
    pub(super) fn is_spurious(&self, amplitude: f64) -> bool {
        const LINEAR: i32 = 1;
        const HALF: f64 = 0.5;
        let count = self.parts.iter().map(Vec::len).max().unwrap_or(0);
        if count < 2 {
            return false;
        }
        let added = |k: usize| -> f64 {
            let orders = self.parts.iter().filter_map(|part| part.get(k));
            orders.flatten().map(|rate| rate.size_above(LINEAR, amplitude)).sum()
        };
        let sizes = std::iter::once(self.frequency * amplitude).chain((0..count).map(added));
        let sizes: Vec<f64> = sizes.filter(|size| *size != 0.0).collect();
        matches!(sizes.as_slice(), [.., before, last] if *last > HALF * before)
    }
}

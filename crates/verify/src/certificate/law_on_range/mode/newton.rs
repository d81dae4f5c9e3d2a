//! Approximate motions of a mode at an amplitude: Newton's iteration in doubles for the harmonics.
//!
//! ```text
//! -k^2 v_ik + mu [g_i(v; a)]_k = 0,     condition(v) = 1,     g_i(v; a) = f_i(a v)/a,     q = a v(omega t),  mu = 1/omega^2
//! ```
//!
//! In: compiled forces, the amplitude and a motion nearby. Out: mu and the harmonics of each coordinate over
//! the amplitude. The harmonics of the forces come from samples of a period; a step costs n^3 products, n the
//! number of harmonics times that of coordinates. Nothing here is trusted.

use nalgebra::{DMatrix, DVector};

use super::super::LawNotProved;
use crate::expr::{CompiledList, Expr};
use crate::numeric::harmonics::Transform;
use crate::symbol::Symbol;

/// A motion over its amplitude.
#[derive(Clone, Debug)]
pub(super) struct ScaledMotion {
    /// `1/omega^2`.
    pub(super) mu: f64,
    /// The cosine coefficients of each coordinate, that of the constant first.
    pub(super) cosines: Vec<Vec<f64>>,
    /// The largest sum of the norms of the derivatives of all forces by one coordinate.
    pub(super) stiffness: f64,
}

/// The definition of the amplitude, in doubles.
#[derive(Clone, Debug)]
pub(super) enum ApproximateCondition {
    /// The start of a coordinate.
    Start(usize),
    /// The first harmonic of a sum of all coordinates with these factors.
    FirstHarmonic(Vec<f64>),
}

/// The equations for the harmonics.
pub(super) struct ModeSolver {
    /// The forces, then their derivatives row by row.
    forces: CompiledList,
    condition: ApproximateCondition,
    count: usize,
    odd: bool,
}

/// The last harmonics that are tried, and the largest number of unknowns.
const LAST: [usize; 4] = [15, 31, 63, 127];
const MOST_UNKNOWNS: usize = 700;

/// The size of the last coefficients up to which no more harmonics are asked for.
const NEGLIGIBLE: f64 = 1e-16;

impl ModeSolver {
    pub(super) fn new(
        forces: &[Expr],
        coordinates: &[Symbol],
        variable: Symbol,
        condition: ApproximateCondition,
        odd: bool,
    ) -> Result<Self, LawNotProved> {
        let mut all = forces.to_vec();
        for force in forces {
            for name in coordinates {
                all.push(force.differentiate(*name)?);
            }
        }
        let letters: Vec<Symbol> = coordinates.iter().copied().chain([variable]).collect();
        let forces = CompiledList::new(&all, &letters)
            .map_err(|error| LawNotProved::NoValue(error.to_string()))?;
        Ok(Self { forces, condition, count: coordinates.len(), odd })
    }

    /// The motion at an amplitude; `None` where the iteration does not end.
    pub(super) fn motion(&self, amplitude: f64, near: &ScaledMotion) -> Option<ScaledMotion> {
        let mut found: Option<ScaledMotion> = None;
        // As many harmonics as the motion nearby needed are needed again.
        let known = near.cosines.iter().map(Vec::len).max().unwrap_or(0);
        let possible = LAST.into_iter().filter(|last| last * self.count <= MOST_UNKNOWNS);
        let possible: Vec<usize> = possible.collect();
        let enough = possible.iter().position(|last| *last + 1 >= known);
        for &last in &possible[enough.unwrap_or(possible.len().saturating_sub(1))..] {
            let from = found.as_ref().unwrap_or(near);
            let motion = self.with_harmonics(amplitude, from, last)?;
            let is_small =
                |list: &Vec<f64>| list.iter().rev().take(2).all(|c| c.abs() < NEGLIGIBLE);
            let is_whole = motion.cosines.iter().all(is_small);
            found = Some(motion);
            if is_whole {
                break;
            }
        }
        found
    }

    /// The motion with harmonics up to a last one.
    fn with_harmonics(
        &self,
        amplitude: f64,
        near: &ScaledMotion,
        last: usize,
    ) -> Option<ScaledMotion> {
        /// The most steps, the size of a step after which none is needed, and of one that is none.
        const STEPS: usize = 14;
        const ENOUGH: f64 = 1e-14;
        const NONE: f64 = 1e-9;
        let mut motion = near.clone();
        for list in &mut motion.cosines {
            list.resize(last + 1, 0.0);
        }
        let mut before = f64::INFINITY;
        for _ in 0..STEPS {
            let (step, stiffness) = self.step(amplitude, &motion, last)?;
            let size: f64 = step.iter().map(|part| part.abs()).sum();
            if !size.is_finite() {
                return None;
            }
            motion.stiffness = stiffness;
            if size >= before && size < NONE {
                break;
            }
            before = size;
            motion.mu -= step[0];
            for (index, (i, k)) in self.waves(last).enumerate() {
                motion.cosines[i][k] -= step[index + 1];
            }
            if size < ENOUGH {
                break;
            }
        }
        (before < NONE).then_some(motion)
    }

    /// The coordinates and harmonics that are unknown.
    fn waves(&self, last: usize) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (first, step) = if self.odd { (1, 2) } else { (0, 1) };
        (0..self.count).flat_map(move |i| (first..=last).step_by(step).map(move |k| (i, k)))
    }

    /// A step of the iteration, and the stiffness along the motion; `None` where the derivative has no
    /// inverse.
    fn step(
        &self,
        amplitude: f64,
        motion: &ScaledMotion,
        last: usize,
    ) -> Option<(DVector<f64>, f64)> {
        let count = self.count;
        let samples = 4 * (last + 1);
        let transform = Transform::new(samples);
        let places: Vec<Vec<f64>> = motion
            .cosines
            .iter()
            .map(|list| transform.sum_of_waves(list.iter().map(|cosine| [*cosine, 0.0])))
            .collect();
        let mut along = vec![vec![0.0; samples]; count + count * count];
        let (mut scratch, mut values) = (vec![], vec![0.0; along.len()]);
        for sample in 0..samples {
            let own = places.iter().map(|place| place[sample]);
            let arguments: Vec<f64> = own.chain([amplitude]).collect();
            self.forces.call(&arguments, &mut scratch, &mut values);
            for (list, value) in along.iter_mut().zip(&values) {
                list[sample] = *value;
            }
        }
        // Coefficients as those of exponentials, s_0 the mean, s_m half of the cosine.
        let halves: Vec<Vec<f64>> = along
            .iter()
            .map(|values| {
                let cosines = transform.harmonics(values, samples / 2).cosines;
                cosines.iter().map(|cosine| cosine / 2.0).collect()
            })
            .collect();
        let slope = |row: usize, column: usize| &halves[count + row * count + column];
        let coefficient = |series: &[f64], k: usize, j: usize| {
            let half = |m: usize| series.get(m).copied().unwrap_or(0.0);
            match (k, j) {
                (0, 0) => half(0),
                (_, 0) => 2.0 * half(k),
                (0, _) => half(j),
                _ => half(k.abs_diff(j)) + half(k + j),
            }
        };
        let force = |i: usize, k: usize| halves[i][k] * if k == 0 { 1.0 } else { 2.0 };
        let waves: Vec<(usize, usize)> = self.waves(last).collect();
        let by_condition = |i: usize, k: usize| match &self.condition {
            ApproximateCondition::Start(own) => f64::from(u8::from(*own == i)),
            ApproximateCondition::FirstHarmonic(factors) if k == 1 => factors[i],
            ApproximateCondition::FirstHarmonic(_) => 0.0,
        };
        let size = waves.len() + 1;
        let mut matrix = DMatrix::zeros(size, size);
        let mut residual = DVector::zeros(size);
        residual[0] = -1.0;
        for (index, &(i, k)) in waves.iter().enumerate() {
            let (row, own, square) = (index + 1, motion.cosines[i][k], (k * k) as f64);
            residual[0] += by_condition(i, k) * own;
            residual[row] = motion.mu * force(i, k) - square * own;
            matrix[(0, row)] = by_condition(i, k);
            matrix[(row, 0)] = force(i, k);
            for (other, &(j, m)) in waves.iter().enumerate() {
                matrix[(row, other + 1)] = motion.mu * coefficient(slope(i, j), k, m);
            }
            matrix[(row, row)] -= square;
        }
        let norm = |series: &[f64]| 2.0 * series.iter().map(|half| half.abs()).sum::<f64>();
        let column = |j: usize| (0..count).map(|i| norm(slope(i, j))).sum::<f64>();
        let stiffness = (0..count).map(column).fold(0.0, f64::max);
        Some((matrix.lu().solve(&residual)?, stiffness))
    }
}

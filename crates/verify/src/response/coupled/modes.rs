//! Nonlinear normal modes: the families of free motions without damping that begin at the linear
//! modes, in their frequency.
//!
//! ```text
//! (K - omega_0^2 M) v = 0,    q = q_0 + epsilon v cos(omega t) + ...,  omega -> omega_0 as epsilon -> 0
//! ```
//!
//! (G. Kerschen, M. Peeters, J. C. Golinval and A. F. Vakakis, *Mech. Syst. Signal Process.* 23
//! (2009) 170; M. Peeters and others, the same volume, 195.) Branch points on them lead to motions of
//! less symmetry, such as localised modes, and to internal resonances.

use nalgebra::{DMatrix, DVector};

use super::branches::Known;
use super::problem::{Anchor, CoupledProblem, Orbit};
use crate::response::{ResponseDiagram, ResponseError};

impl CoupledProblem<'_> {
    /// The nonlinear normal modes in a range of frequencies.
    pub(super) fn mode_response(&self) -> Result<ResponseDiagram, ResponseError> {
        let n = self.coordinates;
        let rest = self.rest().ok_or_else(|| self.nothing_found(Default::default()))?;
        let slopes = self.in_time.linearised(&rest, 0.0, 0.0).by_state;
        let stiffness = DMatrix::from_fn(n, n, |i, j| -slopes[(n + i, j)]);
        let squares = super::changes::eigenvalues(stiffness.clone()).unwrap_or_default();
        let mut frequencies: Vec<f64> = squares
            .iter()
            .filter(|square| square.re > 0.0 && square.im.abs() <= 1e-9 * square.re)
            .map(|square| square.re.sqrt())
            .collect();
        frequencies.sort_by(f64::total_cmp);
        frequencies.dedup_by(|one, other| (*one / *other - 1.0).abs() < 1e-9);
        let linear = frequencies.clone();
        let mut known = Known::default();
        self.question.progress.begin(frequencies.len());
        for frequency in frequencies {
            let square = frequency * frequency;
            let shapes = shapes(&stiffness - DMatrix::identity(n, n) * square);
            // Of equal frequencies small motions of every shift between the coordinates are nearly
            // periodic; those that begin at rest are single.
            let from_rest = shapes.len() > 1;
            for shape in shapes {
                if let Some((orbit, anchor)) = self.small_mode(&rest, frequency, &shape, from_rest)
                {
                    self.add_branch(orbit, anchor, &mut known);
                }
            }
            self.question.progress.advance();
        }
        self.follow_crossings(&mut known);
        if known.branches.is_empty() {
            return Err(match self.question.interrupt.is_requested() {
                true => self.nothing_found(Default::default()),
                false => ResponseError::NoModes { linear, range: self.question.range },
            });
        }
        Ok(self.diagram(&known, vec![], vec![]))
    }

    /// The equilibrium that Newton's method finds from zero.
    pub(super) fn rest(&self) -> Option<Vec<f64>> {
        let (n, m) = (self.states.len(), self.coordinates);
        let mut state = vec![0.0; n];
        for _ in 0..50 {
            let found = self.in_time.linearised(&state, 0.0, 0.0);
            let force = found.rates.rows(m, m).into_owned();
            if force.amax() <= 1e-14 * (1.0 + found.by_state.amax()) {
                return Some(state);
            }
            let slopes = found.by_state.view((m, 0), (m, m)).into_owned();
            let step = slopes.lu().solve(&force)?;
            for (place, step) in state.iter_mut().zip(step.iter()) {
                *place -= step;
            }
        }
        state.iter().all(|value| value.is_finite()).then_some(state)
    }

    /// A motion of the family of a linear mode, of an amplitude at which the frequency has moved
    /// by a small part of the range, and the velocity that is zero at its beginning, with its size.
    /// `None` if the frequency does not change with the amplitude, or the family leads away from the
    /// range.
    fn small_mode(
        &self,
        rest: &[f64],
        frequency: f64,
        shape: &DVector<f64>,
        from_rest: bool,
    ) -> Option<(Orbit, Anchor)> {
        /// Part of the range by which the frequency is to have moved.
        const MOVED: f64 = 2e-3;
        const DOUBLINGS: usize = 24;
        let (n, m) = (self.states.len(), self.coordinates);
        let [low, high] = self.question.range;
        let largest = shape.iamax();
        let mut size = 1e-3 / shape[largest].abs();
        let mut guess = DVector::zeros(n + 2);
        for i in 0..n {
            guess[i] = rest[i] + if i < m { size * shape[i] } else { 0.0 };
        }
        guess[n + 1] = frequency;
        for _ in 0..DOUBLINGS {
            let turn = size * shape[largest].abs();
            let anchor = Anchor { state: largest, size: turn, from_rest, ..Anchor::NONE };
            let travel: Vec<f64> = (0..n)
                .map(|i| size * shape[i % m].abs() * if i < m { 1.0 } else { frequency })
                .collect();
            let sizes = self.sizes(&travel, &[], &guess);
            let mut direction = DVector::zeros(n + 2);
            for i in 0..m {
                direction[i] = size * shape[i] / sizes[i];
            }
            let direction = direction.normalize();
            let orbit = self
                .with_orbits(&[], anchor, |orbits| orbits.orbit_along(&guess, &direction, &sizes));
            // Of equal frequencies small motions of every shape are nearly periodic, and the search
            // succeeds at a larger amplitude.
            let Some(orbit) = orbit else {
                for i in 0..m {
                    guess[i] = rest[i] + 2.0 * (guess[i] - rest[i]);
                }
                size *= 2.0;
                continue;
            };
            let moved = orbit.parameter() - frequency;
            let inside = (low..=high).contains(&orbit.parameter());
            if moved.abs() >= MOVED * (high - low) && inside {
                return Some((orbit, anchor));
            }
            // Outside, a family that leads away never comes into the range.
            let leads_away = (orbit.parameter() < low && moved < -MOVED * (high - low))
                || (orbit.parameter() > high && moved > MOVED * (high - low));
            if leads_away {
                return None;
            }
            // The amplitude grows, the frequency with its square.
            let factor = if inside || moved.abs() < 0.1 * (high - low) { 2.0 } else { 1.2 };
            for i in 0..m {
                guess[i] = rest[i] + factor * (orbit.unknowns[i] - rest[i]);
            }
            guess[n + 1] = frequency + factor * factor * moved;
            size *= factor;
        }
        None
    }
}

/// The directions that a matrix makes zero. Of several independent ones, whose sums are modes as
/// well, those along single coordinates and the sums and differences of pairs of them: of two equal
/// oscillators each alone, both in phase and both out of phase, equally or one of them less.
fn shapes(matrix: DMatrix<f64>) -> Vec<DVector<f64>> {
    /// Ratio to the largest singular value of those that count as zero.
    const ZERO: f64 = 1e-8;
    /// Motion of the other coordinate where one moves more.
    const LESS: f64 = 1.0 / 3.0;
    let n = matrix.ncols();
    let eigen = (matrix.transpose() * &matrix).symmetric_eigen();
    let largest = eigen.eigenvalues.max().max(f64::MIN_POSITIVE);
    let is_zero = |index: &usize| eigen.eigenvalues[*index] <= ZERO * ZERO * largest;
    let zeros: Vec<usize> = (0..n).filter(is_zero).collect();
    if zeros.len() <= 1 || largest <= f64::MIN_POSITIVE {
        let least = eigen.eigenvalues.imin();
        let all = largest <= f64::MIN_POSITIVE;
        if !all {
            return vec![eigen.eigenvectors.column(least).into_owned()];
        }
    }
    let onto = |vector: DVector<f64>| {
        let mut projected = DVector::zeros(n);
        for index in &zeros {
            let column = eigen.eigenvectors.column(*index);
            projected += column * column.dot(&vector);
        }
        projected
    };
    let unit = |index: usize| DVector::from_fn(n, |i, _| f64::from(u8::from(i == index)));
    let mut wanted: Vec<DVector<f64>> = (0..n).map(unit).collect();
    for i in 0..n {
        for j in 0..i {
            wanted.extend([unit(i) + unit(j), unit(i) - unit(j)]);
            for (one, other) in [(i, j), (j, i)] {
                let part = unit(other) * LESS;
                wanted.extend([unit(one) + &part, unit(one) - part]);
            }
        }
    }
    let mut found: Vec<DVector<f64>> = Vec::new();
    for shape in wanted.into_iter().map(onto).filter(|shape| shape.norm() > 1e-6) {
        let shape = shape.normalize();
        if !found.iter().any(|other| other.dot(&shape).abs() > 1.0 - 1e-9) {
            found.push(shape);
        }
    }
    found
}

//! Steady motions of slow equations in numbers, with their stability.
//!
//! ```text
//! B_j(t) = B_j e^(i rho_j t):   sum D_n B_j (B, conj B) = i rho_j B_j
//! ```
//!
//! The rates `rho` are those that the slow phases leave open: none where a drive fixes every phase. All
//! solutions are sought by Newton's method from many starts; in the plane of each amplitude a motion
//! that leaves a mode at rest is no special case. A motion is stable if the eigenvalues of the
//! linearised slow equations have negative real parts, but for the zeros of the phases that are open.

use std::collections::BTreeMap;

use nalgebra::linalg::Schur;
use nalgebra::{DMatrix, DVector};
use num_complex::Complex;
use num_traits::Zero;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::SlowMotion;
use crate::interrupt::Interrupt;
use crate::parallel::par_map;
use crate::solution::defined_values;
use crate::symbol::Symbol;

/// A term of a rate: the number before it, and the powers of each `B_j` and of its conjugate.
type RateTerm = (Complex<f64>, Vec<[usize; 2]>);

/// The powers of each `B_j` and of its conjugate, from the zeroth on.
struct PowerTable {
    /// The number of powers of each.
    count: usize,
    powers: Vec<Complex<f64>>,
}

impl PowerTable {
    /// The number of amplitudes.
    fn modes(&self) -> usize {
        self.powers.len() / (2 * self.count)
    }

    /// The power of an amplitude, or of its conjugate.
    fn power(&self, mode: usize, which: usize, exponent: usize) -> Complex<f64> {
        self.powers[(2 * mode + which) * self.count + exponent]
    }
}

/// Slow equations with numbers for all parameters.
#[derive(Clone, Debug)]
pub struct SlowNumbers {
    /// The terms of each rate.
    rates: Vec<Vec<RateTerm>>,
    /// The highest power of an amplitude in them.
    highest: usize,
    /// A basis of the rates that the phases may have by themselves.
    open: DMatrix<f64>,
    /// The combinations of phases that occur.
    slow_phases: Vec<Vec<i32>>,
}

/// The steady motions of slow equations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SlowSteadyStates {
    /// Those that stand alone, the largest first.
    pub isolated: Vec<SlowSteadyState>,
    /// Whether others are members of families, which are not listed.
    pub has_families: bool,
}

/// A steady motion of slow equations.
#[derive(Clone, Debug, PartialEq)]
pub struct SlowSteadyState {
    /// `a_j`.
    pub amplitudes: Vec<f64>,
    /// `phi_j` at `t = 0`, from -pi to pi.
    pub phases: Vec<f64>,
    /// `phi_j'`: zero where a drive fixes the phase.
    pub turning: Vec<f64>,
    /// The largest real part of the eigenvalues that decide; `None` if there are none.
    pub growth: Option<f64>,
}

impl SlowSteadyState {
    /// Whether small disturbances die out.
    pub fn is_stable(&self) -> bool {
        self.growth.is_some_and(|growth| growth < 0.0)
    }
}

impl SlowMotion {
    /// The slow equations with the values of all parameters.
    ///
    /// # Errors
    /// The first symbol without a value.
    pub fn in_numbers(
        &self,
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Result<SlowNumbers, Symbol> {
        let values = self.values(value_of)?;
        let known = |name: Symbol| {
            let own = values.iter().find(|(known, _)| *known == name).map(|(_, value)| *value);
            own.or_else(|| value_of(name))
        };
        let is_amplitude =
            |name: &Symbol| self.complex_amplitudes.iter().flatten().any(|own| own == name);
        let mut rates: Vec<Vec<RateTerm>> = Vec::new();
        for rate in &self.complex_rates {
            let mut terms: BTreeMap<Vec<[usize; 2]>, Complex<f64>> = BTreeMap::new();
            for (part, unit) in
                [(&rate.real, Complex::new(1.0, 0.0)), (&rate.imaginary, Complex::new(0.0, 1.0))]
            {
                for (monomial, number) in part.terms() {
                    let mut factor = crate::exact::rational::to_f64(number);
                    for (name, exponent) in monomial.factors() {
                        if !is_amplitude(name) {
                            factor *= known(*name).ok_or(*name)?.powi(*exponent);
                        }
                    }
                    let powers = self.complex_amplitudes.iter();
                    let powers: Vec<[usize; 2]> = powers
                        .map(|pair| pair.map(|name| monomial.exponent(name).max(0) as usize))
                        .collect();
                    *terms.entry(powers).or_default() += unit * factor;
                }
            }
            rates.push(terms.into_iter().map(|(powers, factor)| (factor, powers)).collect());
        }
        let count = rates.len();
        let lattice = DMatrix::from_fn(count, count, |row, column| {
            self.slow_phases.get(row).map_or(0.0, |(_, turns)| f64::from(turns[column]))
        });
        // Whole numbers: what is not zero is one at least.
        let decomposed = (lattice.transpose() * &lattice).symmetric_eigen();
        let kept: Vec<usize> =
            (0..count).filter(|index| decomposed.eigenvalues[*index] < 1e-6).collect();
        let open = DMatrix::from_fn(kept.len(), count, |row, column| {
            decomposed.eigenvectors[(column, kept[row])]
        });
        let slow_phases = self.slow_phases.iter().map(|(_, turns)| turns.clone()).collect();
        let exponents = rates.iter().flatten().flat_map(|(_, powers)| powers);
        let highest = exponents.flatten().copied().max().unwrap_or(0);
        Ok(SlowNumbers { rates, highest, open, slow_phases })
    }

    /// The values of what the formulas name, detunings among it.
    ///
    /// # Errors
    /// The first symbol without a value.
    pub fn values(
        &self,
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Result<Vec<(Symbol, f64)>, Symbol> {
        let pi = Symbol::new("pi");
        let value_of =
            |name: Symbol| value_of(name).or_else(|| (name == pi).then_some(std::f64::consts::PI));
        let all: Vec<_> = self.definitions.iter().chain(&self.detunings).cloned().collect();
        defined_values(&all, &value_of)
    }
}

impl SlowNumbers {
    /// `B_j'` at these complex amplitudes.
    pub fn rates(&self, amplitudes: &[Complex<f64>]) -> Vec<Complex<f64>> {
        self.rates_of(&self.powers(amplitudes))
    }

    /// The rates by the powers of the amplitudes.
    fn rates_of(&self, table: &PowerTable) -> Vec<Complex<f64>> {
        let one = |terms: &Vec<RateTerm>| {
            terms.iter().map(|(factor, powers)| factor * product(table, powers, None)).sum()
        };
        self.rates.iter().map(one).collect()
    }

    /// The derivatives of the rates with respect to each amplitude and its conjugate, by the powers of the
    /// amplitudes.
    fn slopes_of(&self, table: &PowerTable) -> Vec<Vec<[Complex<f64>; 2]>> {
        let count = table.modes();
        let one = |terms: &Vec<RateTerm>| {
            let mut row = vec![[Complex::zero(); 2]; count];
            for (factor, powers) in terms {
                for (mode, entry) in row.iter_mut().enumerate() {
                    for (which, slope) in entry.iter_mut().enumerate() {
                        let exponent = powers[mode][which];
                        if exponent != 0 {
                            let lower = product(table, powers, Some((mode, which)));
                            *slope += factor * exponent as f64 * lower;
                        }
                    }
                }
            }
            row
        };
        self.rates.iter().map(one).collect()
    }

    /// The powers of each amplitude and of its conjugate, as far as they occur.
    fn powers(&self, amplitudes: &[Complex<f64>]) -> PowerTable {
        let count = self.highest + 1;
        let mut powers = Vec::with_capacity(2 * amplitudes.len() * count);
        for base in amplitudes.iter().flat_map(|b| [*b, b.conj()]) {
            let mut power = Complex::new(1.0, 0.0);
            for _ in 0..count {
                powers.push(power);
                power *= base;
            }
        }
        PowerTable { count, powers }
    }

    /// `rho_j` from the rates along the basis of what is open.
    fn turning(&self, open: &[f64]) -> Vec<f64> {
        let along = |mode: usize| {
            open.iter().enumerate().map(|(row, rate)| rate * self.open[(row, mode)]).sum()
        };
        (0..self.rates.len()).map(along).collect()
    }

    /// The residual and its derivatives with respect to real and imaginary parts, then the open rates.
    fn equations(&self, place: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let count = self.rates.len();
        let amplitudes: Vec<Complex<f64>> =
            (0..count).map(|mode| Complex::new(place[2 * mode], place[2 * mode + 1])).collect();
        let turning = self.turning(&place.as_slice()[2 * count..]);
        let i = Complex::new(0.0, 1.0);
        let table = self.powers(&amplitudes);
        let mut residual = DVector::zeros(2 * count);
        for (mode, rate) in self.rates_of(&table).into_iter().enumerate() {
            let rest = rate - i * turning[mode] * amplitudes[mode];
            (residual[2 * mode], residual[2 * mode + 1]) = (rest.re, rest.im);
        }
        let mut slopes = DMatrix::zeros(2 * count, place.len());
        for (row, entries) in self.slopes_of(&table).into_iter().enumerate() {
            for (column, [own, conjugate]) in entries.into_iter().enumerate() {
                let mut own = own;
                if row == column {
                    own -= i * turning[row];
                }
                // d/d(re B) = d/dB + d/d(conj B), d/d(im B) = i (d/dB - d/d(conj B))
                let parts = [own + conjugate, i * (own - conjugate)];
                for (part, slope) in parts.into_iter().enumerate() {
                    slopes[(2 * row, 2 * column + part)] = slope.re;
                    slopes[(2 * row + 1, 2 * column + part)] = slope.im;
                }
            }
            for open in 0..self.open.nrows() {
                let slope = -i * self.open[(open, row)] * amplitudes[row];
                slopes[(2 * row, 2 * count + open)] = slope.re;
                slopes[(2 * row + 1, 2 * count + open)] = slope.im;
            }
        }
        (residual, slopes)
    }

    /// The steady motions that are found, the largest first; one of those that differ in phase alone.
    /// Families of motions without isolated members, as without damping, are left out.
    pub fn steady_states(&self, interrupt: Interrupt) -> SlowSteadyStates {
        /// The number of starts for each mode.
        const STARTS: usize = 1000;
        self.steady_states_near(&[], STARTS * self.rates.len(), interrupt)
    }

    /// The steady motions that are found from these, from rest, and from a number of random starts.
    pub fn steady_states_near(
        &self,
        known: &[SlowSteadyState],
        starts: usize,
        interrupt: Interrupt,
    ) -> SlowSteadyStates {
        let count = self.rates.len();
        let mut random = ChaCha8Rng::seed_from_u64(0);
        let mut place_of = |start: usize| {
            let mut place = DVector::zeros(2 * count + self.open.nrows());
            if let Some(state) = start.checked_sub(1).and_then(|index| known.get(index)) {
                for (mode, (a, phase)) in state.amplitudes.iter().zip(&state.phases).enumerate() {
                    (place[2 * mode], place[2 * mode + 1]) =
                        (0.5 * a * phase.cos(), 0.5 * a * phase.sin());
                }
                for row in 0..self.open.nrows() {
                    let along = state.turning.iter().enumerate();
                    place[2 * count + row] =
                        along.map(|(mode, rate)| rate * self.open[(row, mode)]).sum();
                }
            } else if start > 0 {
                for mode in 0..count {
                    let size = 10.0_f64.powf(random.random_range(-5.0..4.5));
                    let phase = random.random_range(0.0..std::f64::consts::TAU);
                    (place[2 * mode], place[2 * mode + 1]) =
                        (size * phase.cos(), size * phase.sin());
                }
            }
            place
        };
        let places: Vec<DVector<f64>> = (0..=known.len() + starts).map(&mut place_of).collect();
        let solve =
            |place: &DVector<f64>| (!interrupt.is_requested()).then(|| self.solved(place.clone()));
        let mut all = SlowSteadyStates::default();
        let found = &mut all.isolated;
        for solved in par_map(&places, solve).into_iter().map_while(|solved| solved) {
            let state = match solved {
                Solved::Isolated(state) => state,
                Solved::Family => {
                    all.has_families = true;
                    continue;
                }
                Solved::Nothing => continue,
            };
            let scale = state.amplitudes.iter().fold(0.0_f64, |most, a| most.max(*a));
            let is_known = |known: &SlowSteadyState| {
                let amplitudes = known.amplitudes.iter().zip(&state.amplitudes);
                known.is_stable() == state.is_stable()
                    && amplitudes
                        .into_iter()
                        .all(|(one, other)| (one - other).abs() <= 1e-7 * scale)
                    && self.slow_phases.iter().all(|turns| same_phase(turns, known, &state))
            };
            if !found.iter().any(is_known) {
                found.push(state);
            }
        }
        found.sort_by(|one, other| {
            let size =
                |state: &SlowSteadyState| state.amplitudes.iter().map(|a| a * a).sum::<f64>();
            size(other).total_cmp(&size(one))
        });
        all
    }

    /// Newton's method with the shortest steps, for phases may be open.
    fn solved(&self, mut place: DVector<f64>) -> Solved {
        const MOST: usize = 60;
        const LARGEST: f64 = 1e7;
        let count = self.rates.len();
        let isolated =
            |place: &DVector<f64>| self.state(place).map_or(Solved::Family, Solved::Isolated);
        let solves = |place: &DVector<f64>, residual: &DVector<f64>, slopes: &DMatrix<f64>| {
            let size = place.rows(0, 2 * count).norm();
            residual.norm() <= 1e-12 * size * slopes.norm() && size > 1e-9
        };
        for step in 0..MOST {
            let (residual, slopes) = self.equations(&place);
            if !residual.iter().all(|entry| entry.is_finite()) {
                return Solved::Nothing;
            }
            // The shortest of the steps that a rate which is open leaves.
            let square = &slopes * slopes.transpose();
            let Some(solution) = square.lu().solve(&residual) else {
                return match solves(&place, &residual, &slopes) {
                    true => isolated(&place),
                    false => Solved::Nothing,
                };
            };
            let change = slopes.transpose() * solution;
            place -= &change;
            let size = place.rows(0, 2 * count).norm();
            if !size.is_finite() || size > LARGEST {
                return Solved::Nothing;
            }
            if change.norm() <= 1e-13 * size.max(1e-3) && step > 0 {
                return isolated(&place);
            }
            if size < 1e-12 {
                place.rows_mut(0, 2 * count).fill(0.0);
                let (residual, _) = self.equations(&place);
                let state = (residual.norm() == 0.0).then(|| self.state(&place)).flatten();
                return state.map_or(Solved::Nothing, Solved::Isolated);
            }
        }
        // Newton's method comes to a family, or to a mode at rest whose phase is open, by halves.
        let (residual, slopes) = self.equations(&place);
        match solves(&place, &residual, &slopes) {
            true => isolated(&place),
            false => Solved::Nothing,
        }
    }

    /// A solution with its stability; `None` if it is one of a family.
    fn state(&self, place: &DVector<f64>) -> Option<SlowSteadyState> {
        /// Ratio to the size of the matrix below which an eigenvalue is zero: rounding moves a double
        /// zero by the root of its own size.
        const ZERO: f64 = 1e-7;
        let count = self.rates.len();
        let (_, slopes) = self.equations(place);
        let squares = (&slopes * slopes.transpose()).symmetric_eigenvalues();
        let moving: Vec<Complex<f64>> =
            (0..count).map(|mode| Complex::new(place[2 * mode], place[2 * mode + 1])).collect();
        let scale = moving.iter().map(|b| b.norm()).fold(0.0, f64::max);
        let at_rest = |b: &Complex<f64>| b.norm() <= 1e-10 * scale;
        // Where a mode is at rest its phase says nothing, and a rate that is open may be anything: the
        // motion is one of a family if the modes that move leave one of their own numbers open.
        if scale > 0.0 && squares.min() <= 1e-14 * squares.max() {
            let at_work: Vec<usize> = (0..count).filter(|mode| !at_rest(&moving[*mode])).collect();
            let rows: Vec<usize> =
                at_work.iter().flat_map(|mode| [2 * mode, 2 * mode + 1]).collect();
            let columns: Vec<usize> =
                rows.iter().copied().chain(2 * count..slopes.ncols()).collect();
            let own = slopes.select_rows(&rows).select_columns(&columns);
            let squares = (&own * own.transpose()).symmetric_eigenvalues();
            if squares.min() <= 1e-14 * squares.max() {
                return None;
            }
        }
        let square = slopes.columns(0, 2 * count).into_owned();
        let largest = square.norm();
        let eigenvalues = Schur::try_new(square, f64::EPSILON, 1000)?.complex_eigenvalues();
        let mut sorted: Vec<Complex<f64>> = eigenvalues.iter().copied().collect();
        sorted.sort_by(|one, other| one.norm().total_cmp(&other.norm()));
        let turning = (0..self.open.nrows())
            .filter(|row| {
                (0..count).any(|mode| {
                    self.open[(*row, mode)].abs() > 1e-9 && !at_rest(&moving[mode]) && scale > 0.0
                })
            })
            .count();
        let decisive = &sorted[turning.min(sorted.len())..];
        if largest > 0.0 && decisive.iter().any(|value| value.norm() <= ZERO * largest) {
            // One of a family, or on the edge of stability.
            return None;
        }
        let growth = decisive.iter().map(|value| value.re).max_by(f64::total_cmp);
        let growth = growth.map(|growth| if growth.abs() <= ZERO * largest { 0.0 } else { growth });
        let amplitude =
            |b: &Complex<f64>| if at_rest(b) || scale == 0.0 { 0.0 } else { 2.0 * b.norm() };
        let phase = |b: &Complex<f64>| {
            let phase = if amplitude(b) == 0.0 { 0.0 } else { b.arg() };
            // What rounding leaves of zero.
            if phase.abs() < 1e-13 { 0.0 } else { phase }
        };
        Some(SlowSteadyState {
            amplitudes: moving.iter().map(amplitude).collect(),
            phases: moving.iter().map(phase).collect(),
            turning: self
                .turning(&place.as_slice()[2 * count..])
                .into_iter()
                .zip(&moving)
                .map(|(rate, b)| if amplitude(b) == 0.0 { 0.0 } else { rate })
                .collect(),
            growth,
        })
    }
}

/// The outcome of Newton's method.
enum Solved {
    Isolated(SlowSteadyState),
    Family,
    Nothing,
}

/// Whether a combination of phases is the same in two motions, or says nothing because a mode in it is
/// at rest.
fn same_phase(turns: &[i32], one: &SlowSteadyState, other: &SlowSteadyState) -> bool {
    let of = |state: &SlowSteadyState| -> Option<f64> {
        let moving = turns.iter().zip(&state.amplitudes).all(|(m, a)| *m == 0 || *a > 0.0);
        let parts = turns.iter().zip(&state.phases).map(|(m, phase)| f64::from(*m) * phase);
        moving.then(|| parts.sum())
    };
    match (of(one), of(other)) {
        (Some(one), Some(other)) => (0.5 * (one - other)).sin().abs() < 1e-5,
        _ => true,
    }
}

/// The product of powers of amplitudes and their conjugates, that at a place with one power less.
fn product(
    table: &PowerTable,
    powers: &[[usize; 2]],
    lower: Option<(usize, usize)>,
) -> Complex<f64> {
    let mut found = Complex::new(1.0, 0.0);
    for (mode, exponents) in powers.iter().enumerate() {
        for (which, exponent) in exponents.iter().enumerate() {
            let exponent = exponent - usize::from(lower == Some((mode, which)));
            if exponent > 0 {
                found *= table.power(mode, which, exponent);
            }
        }
    }
    found
}

//! The orders of the expansion: waves in all frequencies, with polynomials in the complex amplitudes
//! as coefficients.
//!
//! ```text
//! d/dt = i mu + eps D_1 + eps^2 D_2 + ...        on a wave of frequency mu
//! (nu_j^2 - mu^2) eta_(j,n) = r_(j,n),   2 i nu_j D_n B_j = r_(j,n) at mu = nu_j
//! r_n = -(lower orders of d^2/dt^2) - (small terms)_n - (omega_j^2 - nu_j^2) eta_j
//! omega_j^2 - nu_j^2 = -2 nu_j sigma_j + sigma_j^2
//! ```

use std::collections::BTreeMap;

use num_traits::{ToPrimitive, Zero};

use super::answer::KEPT_DIGITS;
use super::modal::ModalForm;
use super::system::SmallTerm;
use super::{MultipleScalesError, NearDivisor};
use crate::decimal::rounded_fraction;
use crate::exact::rational::ratio;
use crate::exact::{ComplexPolynomial, Polynomial, Rational};
use crate::expr::Expr;
use crate::interrupt::Supervision;
use crate::method::Quadrature;
use crate::symbol::Symbol;

/// The frequency of a wave: whole numbers of the divided bases.
pub(super) type WaveVector = Vec<i32>;

/// A real function of the fast phases: the coefficient of each wave, of both signs.
pub(super) type Waves = BTreeMap<WaveVector, ComplexPolynomial>;

/// A small term with its order.
#[derive(Clone, Debug)]
pub(super) struct OrderedTerm {
    pub(super) order: usize,
    pub(super) term: SmallTerm,
}

/// The equations to be expanded, in the waves of all frequencies.
pub(super) struct Problem {
    /// The terms of each equation.
    pub(super) terms: Vec<Vec<OrderedTerm>>,
    /// The waves of the drives, by drive: the row of its frequency, and the divisor of bases.
    pub(super) drives: Vec<WaveVector>,
    /// The row of `nu_j` for each mode.
    pub(super) own: Vec<WaveVector>,
    /// `nu_j`, single terms.
    pub(super) references: Vec<Polynomial>,
    /// The values of the divided bases.
    pub(super) bases: Vec<Polynomial>,
    /// `sigma_j`, and the order at which detunings are small.
    pub(super) detunings: Vec<Polynomial>,
    pub(super) small_order: usize,
    /// `B_j` and its conjugate.
    pub(super) amplitudes: Vec<[Symbol; 2]>,
    pub(super) order: usize,
    pub(super) supervision: Supervision,
    /// The values that are known.
    pub(super) known: BTreeMap<Symbol, f64>,
}

/// The expansion, order by order.
#[derive(Clone, Debug)]
pub(super) struct Expansion {
    /// `eta_(j,n)` by mode, then by order.
    pub(super) displacement: Vec<Vec<Waves>>,
    /// `D_n B_j` by order, then by mode; zero of order zero.
    pub(super) rates: Vec<Vec<ComplexPolynomial>>,
}

/// Series of waves in the orders.
type WaveSeries = Vec<Waves>;

impl Problem {
    /// Expands to the highest order; names of divisors are added to those of the form.
    ///
    /// # Errors
    /// [`MultipleScalesError::Divisor`].
    pub(super) fn expand(&self, form: &mut ModalForm) -> Result<Expansion, MultipleScalesError> {
        let count = self.own.len();
        let mut found = Expansion {
            displacement: vec![vec![]; count],
            rates: vec![vec![ComplexPolynomial::zero(); count]],
        };
        let forced = self.force(0, &[], form);
        for (mode, forced) in forced.iter().enumerate() {
            let own = ComplexPolynomial::real(Polynomial::symbol(self.amplitudes[mode][0]));
            let mut first = self.particular(mode, &negative(forced), form)?;
            accumulate(&mut first, &self.mirrored(Waves::from([(self.own[mode].clone(), own)])));
            found.displacement[mode].push(first);
        }
        // The first and the second derivative of each mode, by order.
        let mut derivatives: Vec<[WaveSeries; 2]> = found
            .displacement
            .iter()
            .map(|series| {
                let velocity = self.derivative(&found, 0, &series[0], form);
                let acceleration = self.derivative(&found, 0, &velocity, form);
                [vec![velocity], vec![acceleration]]
            })
            .collect();
        self.supervision.progress.begin(self.order);
        for order in 1..=self.order {
            if self.supervision.interrupt.is_requested() {
                return Err(MultipleScalesError::Interrupted);
            }
            // D_n B is zero for now: the resonant waves of this order fix it.
            found.rates.push(vec![ComplexPolynomial::zero(); count]);
            let known: Vec<[WaveSeries; 3]> = (0..count)
                .map(|mode| {
                    let [velocity, acceleration] = derivatives[mode].clone();
                    [found.displacement[mode].clone(), velocity, acceleration]
                })
                .collect();
            let force = self.force(order, &known, form);
            let moving: Vec<Waves> = (0..count)
                .map(|mode| self.slow_part(&found, order, &found.displacement[mode], form))
                .collect();
            let mut rates = Vec::new();
            let mut displacements = Vec::new();
            for mode in 0..count {
                let mut right = self.derivative(&found, 0, &moving[mode], form);
                let slow = self.slow_part(&found, order, &derivatives[mode][0], form);
                accumulate(&mut right, &slow);
                accumulate(&mut right, &force[mode]);
                let mut right = negative(&right);
                self.detune(mode, order, &found.displacement[mode], &mut right, form);
                let resonant =
                    right.remove(&self.own[mode]).unwrap_or_else(ComplexPolynomial::zero);
                right.remove(&opposite(&self.own[mode]));
                // 2 i nu D_n B takes the resonant waves away.
                let inverse = self.references[mode].power(-1).unwrap_or_else(Polynomial::zero);
                let half = Polynomial::constant(ratio(-1, 2)).product(&inverse);
                rates.push(tidied(&resonant.times_i().times(&half), form));
                displacements.push(self.particular(mode, &right, form)?);
            }
            found.rates[order] = rates;
            for (mode, displacement) in displacements.into_iter().enumerate() {
                found.displacement[mode].push(displacement);
                let mut velocity =
                    self.derivative(&found, 0, &found.displacement[mode][order], form);
                let slow = self.slow_part(&found, order, &found.displacement[mode], form);
                accumulate(&mut velocity, &slow);
                derivatives[mode][0].push(velocity);
                let mut acceleration =
                    self.derivative(&found, 0, &derivatives[mode][0][order], form);
                let slow = self.slow_part(&found, order, &derivatives[mode][0], form);
                accumulate(&mut acceleration, &slow);
                derivatives[mode][1].push(acceleration);
            }
            self.supervision.progress.advance();
        }
        Ok(found)
    }

    /// The frequency of a wave.
    pub(super) fn frequency(&self, wave: &WaveVector) -> Polynomial {
        let mut sum = Polynomial::zero();
        for (times, base) in wave.iter().zip(&self.bases) {
            sum.accumulate(&base.product(&Polynomial::constant(ratio(i64::from(*times), 1))));
        }
        sum
    }

    /// Adds the terms of the detuning to the right side.
    fn detune(
        &self,
        mode: usize,
        order: usize,
        displacement: &WaveSeries,
        right: &mut Waves,
        form: &ModalForm,
    ) {
        let detuning = &self.detunings[mode];
        if detuning.is_zero() {
            return;
        }
        let twice = self.references[mode].product(&Polynomial::constant(ratio(2, 1)));
        let mut square = detuning.product(detuning);
        square.negate();
        let factors = [twice.product(detuning), square];
        for (times, factor) in (1..).zip(&factors) {
            let Some(lower) = order.checked_sub(times * self.small_order) else { continue };
            for (wave, value) in &displacement[lower] {
                add(right, wave, &tidied(&value.times(factor), form));
            }
        }
    }

    /// The small terms of an order, along a motion known to the order below, projected on each mode.
    /// The motion is displacement, velocity and acceleration of each mode by order.
    fn force(&self, order: usize, motion: &[[WaveSeries; 3]], form: &ModalForm) -> Vec<Waves> {
        let mut coordinates: BTreeMap<(usize, usize), WaveSeries> = BTreeMap::new();
        let by_row: Vec<Waves> = self
            .terms
            .iter()
            .map(|terms| {
                let mut sum = Waves::new();
                for OrderedTerm { order: own, term } in terms {
                    let Some(highest) = order.checked_sub(*own) else { continue };
                    if term.powers.is_empty() && highest > 0 {
                        continue;
                    }
                    let one = ComplexPolynomial::real(term.coefficient.clone());
                    let still = Waves::from([(vec![0; self.bases.len()], one)]);
                    let mut along = vec![still];
                    along.resize(highest + 1, Waves::new());
                    for (coordinate, primes, exponent) in &term.powers {
                        let place = (*coordinate, *primes);
                        let series = coordinates
                            .entry(place)
                            .or_insert_with(|| self.coordinate(place, order, motion, form));
                        for _ in 0..*exponent {
                            along = self.series_product(&along, series, highest, form);
                        }
                    }
                    let mut last = along.swap_remove(highest);
                    for wave in &term.waves {
                        last = self.product(
                            &last,
                            &self.drive(wave.drive, &wave.multiple, wave.quadrature),
                            form,
                        );
                    }
                    accumulate(&mut sum, &last);
                }
                sum
            })
            .collect();
        let project = |row: &Vec<Polynomial>| {
            let mut sum = Waves::new();
            for (factor, force) in row.iter().zip(&by_row).filter(|(factor, _)| !factor.is_zero()) {
                for (wave, value) in force {
                    add(&mut sum, wave, &tidied(&value.times(factor), form));
                }
            }
            sum
        };
        form.projection.iter().map(project).collect()
    }

    /// A coordinate, or a derivative of it, by orders below this one.
    fn coordinate(
        &self,
        (coordinate, primes): (usize, usize),
        order: usize,
        motion: &[[WaveSeries; 3]],
        form: &ModalForm,
    ) -> WaveSeries {
        let at = |order: usize| {
            let mut sum = Waves::new();
            let modes = form.shapes[coordinate].iter().zip(motion);
            for (factor, mode) in modes.filter(|(factor, _)| !factor.is_zero()) {
                for (wave, value) in mode[primes].get(order).into_iter().flatten() {
                    add(&mut sum, wave, &tidied(&value.times(factor), form));
                }
            }
            sum
        };
        (0..order).map(at).collect()
    }

    /// A wave of a drive.
    fn drive(&self, drive: usize, multiple: &Rational, quadrature: Quadrature) -> Waves {
        let half = Polynomial::constant(ratio(1, 2));
        let above = match quadrature {
            Quadrature::Cosine => ComplexPolynomial::real(half),
            Quadrature::Sine => ComplexPolynomial::real(half).times_i().negative(),
        };
        let scaled = |entry: &i32| {
            let times = multiple * Rational::from_integer((*entry).into());
            times.to_integer().to_i32().unwrap_or(i32::MAX)
        };
        let wave: WaveVector = self.drives[drive].iter().map(scaled).collect();
        Waves::from([(opposite(&wave), above.conjugate(&[])), (wave, above)])
    }

    /// The solution for the waves that are not resonant, each divided by `nu_j^2 - mu^2`.
    fn particular(
        &self,
        mode: usize,
        right: &Waves,
        form: &mut ModalForm,
    ) -> Result<Waves, MultipleScalesError> {
        let mut solved = Waves::new();
        for (wave, value) in right.iter().filter(|(wave, _)| is_first(wave)) {
            let value = tidied(value, form);
            if form.is_zero(&value.real) && form.is_zero(&value.imaginary) {
                continue;
            }
            let frequency = self.frequency(wave);
            let mut divisor = frequency.product(&frequency);
            divisor.negate();
            divisor.accumulate(&self.references[mode].product(&self.references[mode]));
            let divisor = form.tidied(&divisor);
            if form.is_zero(&divisor) {
                return Err(MultipleScalesError::Divisor {
                    mode: mode + 1,
                    frequency: Expr::from(&frequency).to_string(),
                });
            }
            self.check_distance(mode, &frequency, form)?;
            let wanted = format!("d{}", form.names.definitions.len() + 1);
            let inverse = form.names.inverse(&divisor, &wanted).unwrap_or_else(Polynomial::zero);
            solved.insert(wave.clone(), tidied(&value.times(&inverse), form));
        }
        Ok(self.mirrored(solved))
    }

    /// Keeps a wave that is near the frequency of a mode, and refuses one that has it.
    fn check_distance(
        &self,
        mode: usize,
        frequency: &Polynomial,
        form: &mut ModalForm,
    ) -> Result<(), MultipleScalesError> {
        const NEAR: f64 = 0.08;
        const EQUAL: f64 = 1e-9;
        let value = |of: &Polynomial| Expr::from(of).evaluate(&self.known).ok();
        let (Some(wave), Some(own)) = (value(frequency), value(&self.references[mode])) else {
            return Ok(());
        };
        let distance = (wave.abs() / own.abs() - 1.0).abs();
        let written = Expr::from(&frequency.map(|number| match form.rounded {
            true => rounded_fraction(number, KEPT_DIGITS),
            false => number.clone(),
        }));
        if distance < EQUAL {
            let frequency = written.to_string();
            return Err(MultipleScalesError::Divisor { mode: mode + 1, frequency });
        }
        let known = form.near.iter().any(|near| near.mode == mode + 1 && near.frequency == written);
        if distance < NEAR && !known {
            form.near.push(NearDivisor { mode: mode + 1, frequency: written, distance });
        }
        Ok(())
    }

    /// `D_0` with the slow parts of a wave, at one order: `i mu` for order zero, `D_n` above.
    fn derivative(
        &self,
        found: &Expansion,
        order: usize,
        waves: &Waves,
        form: &ModalForm,
    ) -> Waves {
        let mut result = Waves::new();
        for (wave, value) in waves.iter().filter(|(wave, _)| is_first(wave)) {
            let mut rate = ComplexPolynomial::zero();
            if order == 0 {
                rate.accumulate(&value.times_i().times(&self.frequency(wave)));
            } else {
                for (own, pair) in found.rates[order].iter().zip(&self.amplitudes) {
                    if own.is_zero() {
                        continue;
                    }
                    rate.accumulate(&value.slope(pair[0]).product(own));
                    let conjugate = own.conjugate(&self.amplitudes);
                    rate.accumulate(&value.slope(pair[1]).product(&conjugate));
                }
            }
            add(&mut result, wave, &tidied(&rate, form));
        }
        self.mirrored(result)
    }

    /// `sum_(1 <= l <= n) D_l series_(n - l)`.
    fn slow_part(
        &self,
        found: &Expansion,
        order: usize,
        series: &WaveSeries,
        form: &ModalForm,
    ) -> Waves {
        let mut sum = Waves::new();
        for lower in 1..=order {
            let part = self.derivative(found, lower, &series[order - lower], form);
            accumulate(&mut sum, &part);
        }
        sum
    }

    fn series_product(
        &self,
        left: &[Waves],
        right: &[Waves],
        highest: usize,
        form: &ModalForm,
    ) -> WaveSeries {
        let mut result = vec![Waves::new(); highest + 1];
        for (i, a) in left.iter().enumerate() {
            for (j, b) in right.iter().enumerate().take((highest + 1).saturating_sub(i)) {
                if !a.is_empty() && !b.is_empty() {
                    accumulate(&mut result[i + j], &self.product(a, b, form));
                }
            }
        }
        result
    }

    /// The product of two real functions: waves of the second half are conjugates of the first.
    fn product(&self, left: &Waves, right: &Waves, form: &ModalForm) -> Waves {
        let mut result = Waves::new();
        for (m, a) in left {
            for (n, b) in right {
                let sum: WaveVector = m.iter().zip(n).map(|(m, n)| m + n).collect();
                if is_first(&sum) {
                    add(&mut result, &sum, &tidied(&a.product(b), form));
                }
            }
        }
        self.mirrored(result)
    }

    /// A real function from the first half of its waves.
    fn mirrored(&self, mut waves: Waves) -> Waves {
        let others: Vec<(WaveVector, ComplexPolynomial)> = waves
            .iter()
            .filter(|(wave, _)| wave.iter().any(|m| *m != 0))
            .map(|(wave, value)| (opposite(wave), value.conjugate(&self.amplitudes)))
            .collect();
        waves.extend(others);
        waves
    }
}

/// Whether a wave is constant, or the first of the two with its frequency.
pub(super) fn is_first(wave: &WaveVector) -> bool {
    wave.iter().find(|m| **m != 0).is_none_or(|m| *m > 0)
}

pub(super) fn opposite(wave: &WaveVector) -> WaveVector {
    wave.iter().map(|m| -m).collect()
}

fn tidied(value: &ComplexPolynomial, form: &ModalForm) -> ComplexPolynomial {
    value.map(|part| form.tidied(part))
}

fn add(waves: &mut Waves, wave: &WaveVector, term: &ComplexPolynomial) {
    let known = waves.entry(wave.clone()).or_insert_with(ComplexPolynomial::zero);
    known.accumulate(term);
    if known.is_zero() {
        waves.remove(wave);
    }
}

fn accumulate(sum: &mut Waves, waves: &Waves) {
    for (wave, term) in waves {
        add(sum, wave, term);
    }
}

fn negative(waves: &Waves) -> Waves {
    waves.iter().map(|(wave, value)| (wave.clone(), value.clone().negative())).collect()
}

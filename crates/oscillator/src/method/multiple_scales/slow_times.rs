//! The expansion in slow times: the contribution of each order to the motion, and the rate of the
//! complex amplitude on each time.
//!
//! Reference: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, sections 2.3.3, 4.1
//! and 5.7.
//!
//! ```text
//! x = sum eps^k x_k(T0, T1, ...),   T_k = eps^k t,   d/dt = D0 + eps D1 + eps^2 D2 + ...
//! x_0 = B e^(i s phi) + cc (+ Lambda e^(i r phi) + cc),   D0 phi = omega0/s,   D_d phi = detuning
//! D0^2 x_k + omega0^2 x_k = -(sum of D_i D_j x_l, i + j + l = k, l < k) - (force)_k
//! no e^(i s phi) on the right:   2 i omega0 D_k B = what stands there without it
//! ```
//!
//! Time derivatives are taken one after the other, so `D_i D_j` follows by the chain rule from the
//! `D_k B` found before, and there are as many slow times as there are orders. `x_k` has no
//! homogeneous solution. A free motion has `s = 1` and turns with the linear frequency; a driven
//! one turns with a fraction of the driving frequency, from which the linear frequency is detuned.
//! `Lambda e^(i r phi)` solves the linear equation with a drive far from resonance, so the two
//! cancel.

use std::collections::BTreeMap;

use num_traits::{One, Zero};

use crate::exact::rational::ratio;
use crate::exact::{ComplexPolynomial as Complex, Polynomial, Rational};
use crate::method::drive::Quadrature;
use crate::symbol::Symbol;

/// `B` and its conjugate, as symbols.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ComplexAmplitude {
    /// `B`.
    pub own: Symbol,
    /// Its conjugate.
    pub conjugate: Symbol,
}

/// A real function of the fast phase: the coefficient of `e^(i m phi)` by `m`, of both signs.
pub(super) type FastPhaseSeries = BTreeMap<i32, Complex>;

/// A term of the force on the left side, `eps^order coefficient x^position x'^velocity` times a
/// wave of the drive.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DrivenTerm {
    /// Power of the small parameter, at least one.
    pub order: usize,
    /// Power of the coordinate.
    pub position: u32,
    /// Power of the velocity.
    pub velocity: u32,
    /// The rest, without the small parameter.
    pub coefficient: Polynomial,
    /// The wave `cos(m phi)` or `sin(m phi)` of the drive; `None` for a term without time.
    pub drive: Option<(i32, Quadrature)>,
}

/// The problem to be expanded.
pub(super) struct ScaledProblem {
    /// The terms of the force beside the linear one.
    pub terms: Vec<DrivenTerm>,
    /// `omega0`, a single term.
    pub linear_frequency: Polynomial,
    /// `s`: the harmonic of the fast phase at which the motion swings freely.
    pub own: i32,
    /// The order of the detuning and its size: the rate of the fast phase less `omega0/s`.
    pub detuning: Option<(usize, Polynomial)>,
    /// Motions that drives far from resonance force at leading order: their harmonics `r`, and
    /// `Lambda` of each.
    pub forced: Vec<(i32, Complex)>,
    /// The highest order.
    pub order: usize,
}

/// The expansion, order by order.
pub(super) struct MultipleScalesExpansion {
    /// `x_0`, `x_1`, ...
    pub displacement: Vec<FastPhaseSeries>,
    /// `D_k B`; the first entry, that of the fast time, is zero.
    pub rates: Vec<Complex>,
    /// The coefficient of `e^(i s phi)` that `D_k B` removes, by order.
    pub resonant: Vec<Complex>,
}

impl ComplexAmplitude {
    /// The pair that a conjugate exchanges.
    fn pair(self) -> [Symbol; 2] {
        [self.own, self.conjugate]
    }
}

fn number(value: i64) -> Polynomial {
    Polynomial::constant(Rational::from_integer(value.into()))
}

fn add(wave: &mut FastPhaseSeries, harmonic: i32, term: &Complex) {
    let known = wave.entry(harmonic).or_insert_with(Complex::zero);
    known.accumulate(term);
    if known.is_zero() {
        wave.remove(&harmonic);
    }
}

fn accumulate(sum: &mut FastPhaseSeries, wave: &FastPhaseSeries) {
    for (harmonic, term) in wave {
        add(sum, *harmonic, term);
    }
}

/// The product of two real waves: harmonics below zero are conjugates of those above.
fn product(
    left: &FastPhaseSeries,
    right: &FastPhaseSeries,
    amplitude: ComplexAmplitude,
) -> FastPhaseSeries {
    let mut result = FastPhaseSeries::new();
    for (m, a) in left {
        for (n, b) in right {
            if m + n >= 0 {
                add(&mut result, m + n, &a.product(b));
            }
        }
    }
    mirrored(result, amplitude)
}

/// A real wave from its harmonics from zero on.
fn mirrored(mut wave: FastPhaseSeries, amplitude: ComplexAmplitude) -> FastPhaseSeries {
    let above: Vec<(i32, Complex)> = wave
        .iter()
        .filter(|entry| *entry.0 > 0)
        .map(|(m, value)| (-m, value.conjugate(&[amplitude.pair()])))
        .collect();
    wave.extend(above);
    wave
}

/// Power series of waves, cut after `highest`.
fn series_product(
    left: &[FastPhaseSeries],
    right: &[FastPhaseSeries],
    highest: usize,
    amplitude: ComplexAmplitude,
) -> Vec<FastPhaseSeries> {
    let mut result = vec![FastPhaseSeries::new(); highest + 1];
    for (i, a) in left.iter().enumerate() {
        for (j, b) in right.iter().enumerate().take((highest + 1).saturating_sub(i)) {
            if !a.is_empty() && !b.is_empty() {
                accumulate(&mut result[i + j], &product(a, b, amplitude));
            }
        }
    }
    result
}

fn series_power(
    base: &[FastPhaseSeries],
    exponent: u32,
    highest: usize,
    amplitude: ComplexAmplitude,
) -> Vec<FastPhaseSeries> {
    let mut result =
        vec![FastPhaseSeries::from([(0, Complex::real(Polynomial::constant(Rational::one())))])];
    let mut square = base.to_vec();
    let mut rest = exponent;
    while rest > 0 {
        if rest & 1 == 1 {
            result = series_product(&result, &square, highest, amplitude);
        }
        rest >>= 1;
        if rest > 0 {
            square = series_product(&square, &square, highest, amplitude);
        }
    }
    result
}

impl ScaledProblem {
    /// Expands to the highest order.
    pub(super) fn expand(&self, amplitude: ComplexAmplitude) -> MultipleScalesExpansion {
        let inverse = self.linear_frequency.power(-1).unwrap_or_else(Polynomial::zero);
        let own = Complex::real(Polynomial::symbol(amplitude.own));
        let mut found = MultipleScalesExpansion {
            displacement: vec![mirrored(FastPhaseSeries::from([(self.own, own)]), amplitude)],
            rates: vec![Complex::zero()],
            resonant: vec![Complex::zero()],
        };
        let (forced, forced_velocity) = self.forced_motion(amplitude);
        // d/dt of the free part, order by order; that of a forced part is known beforehand.
        let mut velocity = vec![self.derivative(&found, 0, &found.displacement[0], amplitude)];
        for order in 1..=self.order {
            // D_k B is zero for now: the resonant terms of this order will fix it.
            found.rates.push(Complex::zero());
            let mut moving = FastPhaseSeries::new();
            for j in 1..=order {
                let part = self.derivative(&found, j, &found.displacement[order - j], amplitude);
                accumulate(&mut moving, &part);
            }
            let mut right = self.derivative(&found, 0, &moving, amplitude);
            for j in 1..=order {
                accumulate(
                    &mut right,
                    &self.derivative(&found, j, &velocity[order - j], amplitude),
                );
            }
            let total =
                |own: &[FastPhaseSeries], forced: &[FastPhaseSeries]| -> Vec<FastPhaseSeries> {
                    let sum = |k: usize| {
                        let mut sum = own.get(k).cloned().unwrap_or_default();
                        accumulate(&mut sum, forced.get(k).unwrap_or(&FastPhaseSeries::new()));
                        sum
                    };
                    (0..order).map(sum).collect()
                };
            let positions = total(&found.displacement, &forced);
            let velocities = total(&velocity, &forced_velocity);
            accumulate(&mut right, &self.force(order, &positions, &velocities, amplitude));
            right = right.into_iter().map(|(m, term)| (m, term.negative())).collect();
            let resonant = right.get(&self.own).cloned().unwrap_or_else(Complex::zero);
            // 2 i omega0 D_k B takes the resonant terms away.
            let half = Polynomial::constant(ratio(-1, 2)).product(&inverse);
            let rate = resonant.times_i().times(&half);
            let displacement = self.particular(&right, &inverse);
            let mut fast = self.derivative(&found, 0, &displacement, amplitude);
            accumulate(&mut fast, &moving);
            let turned = FastPhaseSeries::from([(self.own, rate.clone())]);
            accumulate(&mut fast, &mirrored(turned, amplitude));
            velocity.push(fast);
            found.displacement.push(displacement);
            found.rates[order] = rate;
            found.resonant.push(resonant);
        }
        // A forced part is part of the motion.
        if let Some(own) = forced.first() {
            accumulate(&mut found.displacement[0], own);
        }
        found
    }

    /// The forced part and its velocity, order by order.
    fn forced_motion(
        &self,
        amplitude: ComplexAmplitude,
    ) -> (Vec<FastPhaseSeries>, Vec<FastPhaseSeries>) {
        if self.forced.is_empty() {
            return (vec![], vec![]);
        }
        let wave = mirrored(self.forced.iter().cloned().collect(), amplitude);
        let still = MultipleScalesExpansion {
            displacement: vec![],
            rates: vec![Complex::zero(); self.order + 1],
            resonant: vec![],
        };
        let velocity = (0..=self.order).map(|j| self.derivative(&still, j, &wave, amplitude));
        (vec![wave.clone()], velocity.collect())
    }

    /// `D_j` of a wave, with the `D_k B` that are known.
    fn derivative(
        &self,
        found: &MultipleScalesExpansion,
        j: usize,
        wave: &FastPhaseSeries,
        amplitude: ComplexAmplitude,
    ) -> FastPhaseSeries {
        let mut result = FastPhaseSeries::new();
        let turning = match &self.detuning {
            _ if j == 0 => Some(
                self.linear_frequency.product(&Polynomial::constant(ratio(1, self.own.into()))),
            ),
            Some((order, detuning)) if *order == j => Some(detuning.clone()),
            _ => None,
        };
        for (m, value) in wave.iter().filter(|entry| *entry.0 >= 0) {
            if let Some(turning) = &turning {
                let rate = turning.product(&number((*m).into()));
                add(&mut result, *m, &value.times_i().times(&rate));
            }
            let rate = &found.rates[j];
            if !rate.is_zero() {
                add(&mut result, *m, &value.slope(amplitude.own).product(rate));
                let conjugate = rate.conjugate(&[amplitude.pair()]);
                add(&mut result, *m, &value.slope(amplitude.conjugate).product(&conjugate));
            }
        }
        mirrored(result, amplitude)
    }

    /// The force beside the linear one at an order, along a motion known to the order below.
    fn force(
        &self,
        order: usize,
        positions: &[FastPhaseSeries],
        velocities: &[FastPhaseSeries],
        amplitude: ComplexAmplitude,
    ) -> FastPhaseSeries {
        let mut sum = FastPhaseSeries::new();
        for term in self.terms.iter().filter(|term| term.order <= order) {
            let highest = order - term.order;
            let x = series_power(positions, term.position, highest, amplitude);
            let v = series_power(velocities, term.velocity, highest, amplitude);
            let product_of_powers = series_product(&x, &v, highest, amplitude);
            let Some(along) = product_of_powers.get(highest) else {
                continue;
            };
            let mut along = along.clone();
            if let Some((harmonic, quadrature)) = term.drive {
                along = product(&along, &drive(harmonic, quadrature), amplitude);
            }
            for (m, value) in &along {
                add(&mut sum, *m, &value.times(&term.coefficient));
            }
        }
        sum
    }

    /// The particular solution for the terms that are not resonant, each divided by `omega0^2 (1 -
    /// (m/s)^2)`.
    fn particular(&self, right: &FastPhaseSeries, inverse: &Polynomial) -> FastPhaseSeries {
        let own = i64::from(self.own);
        let solved = right.iter().filter(|entry| entry.0.abs() != self.own).map(|(m, value)| {
            let m = i64::from(*m);
            let divisor = Polynomial::constant(ratio(own * own, own * own - m * m));
            (m as i32, value.times(&divisor.product(inverse).product(inverse)))
        });
        solved.collect()
    }
}

/// `cos(m phi)` or `sin(m phi)`.
fn drive(harmonic: i32, quadrature: Quadrature) -> FastPhaseSeries {
    let half = Polynomial::constant(ratio(1, 2));
    let above = match quadrature {
        Quadrature::Cosine => Complex::real(half),
        Quadrature::Sine => Complex::real(half).times_i().negative(),
    };
    let below = above.conjugate(&[]);
    FastPhaseSeries::from([(harmonic, above), (-harmonic, below)])
}

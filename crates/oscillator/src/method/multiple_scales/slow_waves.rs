//! The slow equations of a driven motion as waves of the slow phase, and their steady motions.

use std::collections::BTreeMap;

use num_integer::Integer as _;
use num_traits::Zero;

use super::driven::DrivenProblem;
use super::names::ExpansionSymbols;
use super::slow_times::MultipleScalesExpansion;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{ComplexPolynomial as Complex, Polynomial, Rational};
use crate::expr::Expr;
use crate::method::Refusal;
use crate::method::frequency_response::{FrequencyResponse, PhaseWaves, eliminated, turning};
use crate::solution::Response;
use crate::solution::response::Plane;
use crate::symbol::{Symbol, fresh};

/// `a'` and `a psi'/p` as waves of the slow phase, by its multiple: cosines and sines.
pub(super) struct SlowRates {
    pub(super) amplitude: PhaseWaves,
    pub(super) phase: PhaseWaves,
}

impl SlowRates {
    pub(super) fn new(expansion: &MultipleScalesExpansion, question: &DrivenProblem) -> Self {
        Self::of_orders(expansion, question, |_| true)
    }

    /// The contribution of some of the orders.
    pub(super) fn of_orders(
        expansion: &MultipleScalesExpansion,
        question: &DrivenProblem,
        wanted: impl Fn(usize) -> bool,
    ) -> Self {
        let zero = || [Polynomial::zero(), Polynomial::zero()];
        let (mut amplitude, mut phase) = (BTreeMap::new(), BTreeMap::new());
        let names = &question.names;
        let p = i64::from(question.resonance.0);
        let orders = expansion.rates.iter().enumerate().skip(1);
        for (k, rate) in orders.filter(|(k, _)| wanted(*k)) {
            let mark = names.mark(k);
            for (part, imaginary) in [(&rate.real, false), (&rate.imaginary, true)] {
                for (monomial, number) in part.terms() {
                    let turns = monomial.exponent(names.complex.own)
                        - monomial.exponent(names.complex.conjugate)
                        - 1;
                    let term = Polynomial::term(
                        monomial.clone(),
                        number * Rational::from_integer(2.into()),
                    );
                    let term = names.polar(&term).times_monomial(&mark);
                    let multiple = i64::from(turns).unsigned_abs() / p.unsigned_abs();
                    let multiple = u32::try_from(multiple).unwrap_or(u32::MAX);
                    // C e^(-i n psi): the real part is a', minus the imaginary part a psi'/p.
                    let sign = Polynomial::constant(ratio(if turns < 0 { -1 } else { 1 }, 1));
                    let minus = Polynomial::constant(ratio(-1, 1));
                    let rates = amplitude.entry(multiple).or_insert_with(zero);
                    let phases = phase.entry(multiple).or_insert_with(zero);
                    match imaginary {
                        false => {
                            rates[0].accumulate(&term);
                            phases[1].accumulate(&term.product(&sign));
                        }
                        true => {
                            rates[1].accumulate(&term.product(&sign));
                            phases[0].accumulate(&term.product(&minus));
                        }
                    }
                }
            }
        }
        // The constant part has no sine.
        for waves in [&mut amplitude, &mut phase] {
            if let Some([_, sine]) = waves.get_mut(&0) {
                *sine = Polynomial::zero();
            }
        }
        Self { amplitude, phase }
    }

    pub(super) fn is_resonant(&self) -> bool {
        self.multiple() > 0
    }

    /// The greatest common divisor of the multiples of the phase that occur: one, unless a symmetry
    /// makes it larger; zero if the phase does not occur.
    fn multiple(&self) -> u32 {
        let moving = self.amplitude.iter().chain(&self.phase);
        let moving = moving.filter(|(_, waves)| !waves.iter().all(Zero::is_zero));
        moving.fold(0, |common, (multiple, _)| common.gcd(multiple))
    }

    /// The rates as waves of that multiple.
    fn by_multiple(&self) -> [PhaseWaves; 2] {
        let common = self.multiple().max(1);
        [&self.amplitude, &self.phase].map(|rate| {
            let own = rate.iter().filter(|(multiple, _)| *multiple % common == 0);
            own.map(|(multiple, waves)| (multiple / common, waves.clone())).collect()
        })
    }

    /// The constant part of the waves: `P` or `Q`.
    pub(super) fn constant_part(waves: &PhaseWaves) -> Polynomial {
        waves.get(&0).map_or_else(Polynomial::zero, |waves| waves[0].clone())
    }

    /// `a'` and `psi'`.
    pub(super) fn rates(&self, question: &DrivenProblem) -> Result<[Expr; 2], Refusal> {
        let names = &question.names;
        let times = Rational::from_integer(question.resonance.0.into());
        let over = Polynomial::term(Monomial::power_of(names.amplitude, -1), times);
        let amplitude =
            Self::expression(&self.amplitude, names.phase, &|part| question.unmarked(part))?;
        let by_amplitude = |part: &Polynomial| question.unmarked(&part.product(&over));
        Ok([amplitude, Self::expression(&self.phase, names.phase, &by_amplitude)?])
    }

    fn expression(
        waves: &PhaseWaves,
        phase: Symbol,
        change: &dyn Fn(&Polynomial) -> Polynomial,
    ) -> Result<Expr, Refusal> {
        let mut terms = Vec::new();
        for (multiple, [cosine, sine]) in waves {
            let angle = &Expr::from(i64::from(*multiple)) * &Expr::from(phase);
            terms.push(&Expr::from(&change(cosine)) * &angle.cos()?);
            if *multiple > 0 {
                terms.push(&Expr::from(&change(sine)) * &angle.sin()?);
            }
        }
        Ok(Expr::sum(terms))
    }
}

/// The frequency of the free undamped motion, at which `Q = 0`, in powers of the marker: `omega0 +
/// sigma/p`.
pub(super) fn backbone(still: &Polynomial, question: &DrivenProblem) -> Polynomial {
    let names = &question.names;
    let order = question.scaling.order as i32;
    let (sigma, a) = (question.sigma, names.amplitude);
    let own = Monomial::power_of(sigma, 1)
        .product(&Monomial::power_of(a, 1))
        .product(&names.mark(question.small_order()));
    // Q = (sigma/p) a + rest: sigma = -p rest/a, substituted until it no longer changes.
    let mut rest = still.clone();
    let slope = rest.coefficient(&own);
    rest.add_term(own, -slope.clone());
    let over = Polynomial::term(
        Monomial::power_of(a, -1)
            .product(&Monomial::power_of(names.marker, -(question.small_order() as i32))),
        if slope.is_zero() { Rational::zero() } else { -slope.recip() },
    );
    let mut detuning = Polynomial::zero();
    for _ in 0..=order {
        let next =
            rest.substitute(sigma, &detuning).unwrap_or_else(Polynomial::zero).product(&over);
        detuning = next.truncated(names.marker, order - question.small_order() as i32);
    }
    let p = Polynomial::constant(ratio(1, question.resonance.0.into()));
    let mut frequency = detuning.product(&p).times_monomial(&names.mark(question.small_order()));
    frequency.accumulate(&question.linear_frequency);
    frequency
}

/// Everything that follows from the slow equations of a steady motion, which is itself written to
/// an order of its own.
pub(super) fn response(
    question: &DrivenProblem,
    expansion: &MultipleScalesExpansion,
    slow: &SlowRates,
    highest: usize,
) -> Result<Response, Refusal> {
    let a = question.names.amplitude;
    let unmarked = |polynomial: Polynomial| question.unmarked(&polynomial);
    let rates = slow.by_multiple();
    let order = question.scaling.order as i32;
    let inverse = fresh("D", &question.taken);
    let cut = eliminated(rates.each_ref(), question.names.marker, order, inverse).map(unmarked);
    let is_simple = |rate: &PhaseWaves| {
        let mut above = rate.iter().filter(|(multiple, _)| **multiple > 1);
        above.all(|(_, waves)| waves.iter().all(Zero::is_zero))
    };
    let found = match rates.iter().all(is_simple) {
        true => {
            let still = rates.each_ref().map(|waves| unmarked(SlowRates::constant_part(waves)));
            let waves = rates.each_ref().map(|waves| turning(waves).map(unmarked));
            FrequencyResponse::from_rates(still.each_ref(), &waves, question.sigma, a).cut(cut, a)
        }
        false => FrequencyResponse::of_relation(cut, a),
    };
    let [u, v] = ["u", "v"].map(|name| fresh(name, &question.taken));
    Ok(Response {
        motion: motion(question, expansion, |k| k <= highest)?,
        relation: found.relation,
        branches: found.branches,
        peak: found.peak,
        folds: found.folds,
        jumps: found.jumps,
        closed: None,
        plane: Some(plane(question, expansion, [u, v])),
    })
}

/// The contribution of some of the orders to `x(t)`, in `t`, the amplitude and the phase.
pub(super) fn motion(
    question: &DrivenProblem,
    expansion: &MultipleScalesExpansion,
    wanted: impl Fn(usize) -> bool,
) -> Result<Expr, Refusal> {
    let names = &question.names;
    let p = i64::from(question.resonance.0);
    let omega_t = question.drive.angle();
    let psi = Expr::from(names.phase);
    let mut waves: BTreeMap<(i64, i64), [Polynomial; 2]> = BTreeMap::new();
    let orders = expansion.displacement.iter().enumerate();
    for (k, wave) in orders.filter(|(k, _)| wanted(*k)) {
        for (m, value) in wave.iter().filter(|entry| *entry.0 >= 0) {
            for (part, imaginary) in [(&value.real, false), (&value.imaginary, true)] {
                for (monomial, number) in part.terms() {
                    let turns = i64::from(
                        monomial.exponent(names.complex.own)
                            - monomial.exponent(names.complex.conjugate),
                    );
                    let factor = if *m == 0 { ratio(1, 1) } else { ratio(2, 1) };
                    let term = names.polar(&Polynomial::term(monomial.clone(), number * factor));
                    let term = question.unmarked(&term.times_monomial(&names.mark(k)));
                    let zero = || [Polynomial::zero(), Polynomial::zero()];
                    let entry = waves.entry((i64::from(*m), turns)).or_insert_with(zero);
                    entry[usize::from(imaginary)].accumulate(&term);
                }
            }
        }
    }
    // e^(i m phi) B^j Bc^l with phi = Omega t/p and B = (a/2) e^(-i psi/p).
    let mut terms = Vec::new();
    for ((m, turns), [real, imaginary]) in &waves {
        let angle =
            &(&Expr::number(ratio(*m, p)) * &omega_t) - &(&Expr::number(ratio(*turns, p)) * &psi);
        terms.push(&Expr::from(real) * &angle.cos()?);
        if !imaginary.is_zero() {
            terms.push(&(-&Expr::from(imaginary)) * &angle.sin()?);
        }
    }
    Ok(Expr::sum(terms))
}

/// The slow equations in `u = a cos(psi/p)` and `v = -a sin(psi/p)`, that is `2 B = u + i v`:
/// without a singular origin.
fn plane(
    question: &DrivenProblem,
    expansion: &MultipleScalesExpansion,
    coordinates: [Symbol; 2],
) -> Plane {
    let names = &question.names;
    let mut parts: BTreeMap<SlowPart, BTreeMap<usize, Complex>> = BTreeMap::new();
    for (k, rate) in expansion.rates.iter().enumerate().skip(1) {
        for (terms, imaginary) in [(&rate.real, false), (&rate.imaginary, true)] {
            for (monomial, number) in terms.terms() {
                let turns = monomial.exponent(names.complex.own)
                    - monomial.exponent(names.complex.conjugate)
                    - 1;
                let part = match (turns, imaginary) {
                    (0, false) => SlowPart::Drains,
                    (0, true) => SlowPart::Turns,
                    (turns, _) => SlowPart::Wave(turns.unsigned_abs()),
                };
                let term = in_plane(monomial, number, names, coordinates);
                let order = parts.entry(part).or_default().entry(k).or_insert_with(Complex::zero);
                let mark = Complex::real(Polynomial::term(names.mark(k), ratio(1, 1)));
                let term = term.product(&mark);
                order.accumulate(&if imaginary { term.times_i() } else { term });
            }
        }
    }
    let unmarked =
        |sum: &Complex| [question.unmarked(&sum.real), question.unmarked(&sum.imaginary)];
    let mut rates = Complex::zero();
    for order in parts.values().flat_map(BTreeMap::values) {
        rates.accumulate(order);
    }
    // All orders from the leading one on, including those that are zero.
    let by_orders = |orders: &BTreeMap<usize, Complex>| {
        let (first, last) = (orders.keys().next()?, orders.keys().next_back()?);
        let order = |k| unmarked(orders.get(&k).unwrap_or(&Complex::zero()));
        Some((*first..=*last).map(order).collect::<Vec<_>>())
    };
    let parts: Vec<Vec<[Polynomial; 2]>> = parts.values().filter_map(by_orders).collect();
    let several = parts.iter().any(|part| part.len() > 1);
    Plane { coordinates, rates: unmarked(&rates), parts: if several { parts } else { vec![] } }
}

/// The parts of the slow equations, each with a leading order of its own.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum SlowPart {
    /// `a'` without the phase.
    Drains,
    /// `psi'` without the phase.
    Turns,
    /// The harmonic of the phase with this number.
    Wave(u32),
}

/// A term of `2 B'` in `u` and `v`.
fn in_plane(
    monomial: &Monomial,
    number: &Rational,
    names: &ExpansionSymbols,
    [u, v]: [Symbol; 2],
) -> Complex {
    let half = Polynomial::constant(ratio(1, 2));
    let of = |sign: i64| Complex {
        real: Polynomial::symbol(u).product(&half),
        imaginary: Polynomial::symbol(v).product(&Polynomial::constant(ratio(sign, 2))),
    };
    let rest = monomial.without(names.complex.own).without(names.complex.conjugate);
    let mut term = Complex::real(Polynomial::term(rest, number * Rational::from_integer(2.into())));
    for (name, value) in [(names.complex.own, of(1)), (names.complex.conjugate, of(-1))] {
        for _ in 0..monomial.exponent(name) {
            term = term.product(&value);
        }
    }
    term
}

//! From a force with symbols to an exact expansion over whole numbers, and back.
//!
//! A symbol that enters in step with the order of a term (Duffing depends on `eps*A^2` alone) is
//! left out while expanding and put back afterwards. Where that takes care of all symbols the
//! expansion runs over whole numbers, otherwise over polynomials with whole coefficients.

use std::collections::BTreeSet;

use num_integer::Integer as _;
use num_traits::{One, ToPrimitive, Zero};

use super::secular::{
    AmplitudeKind, ExpansionScope, Factored, ForceTerm, Scheme, SecularError, SecularExpansion,
    expand_numbers_supervised, expand_polynomials_supervised, expand_supervised,
};
use crate::derivation::{AmplitudeCondition, Condition, Step};
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{Integer, Integers, POLYNOMIALS, Polynomial, Polynomials, Rational, Ring};
use crate::expr::Expr;
use crate::interrupt::Supervision;
use crate::oscillator::Term;
use crate::series::FourierSeries;
use crate::solution::AmplitudeConvention;
use crate::symbol::{Symbol, fresh_stem};

/// Frequency and motion in units of the linear frequency and the amplitude, as polynomials.
pub struct ExactSeries {
    /// omega.
    pub frequency: Polynomial,
    /// omega^2.
    pub frequency_squared: Polynomial,
    /// The motion.
    pub displacement: FourierSeries<Polynomials>,
    /// Each order by itself, the unperturbed one first.
    pub steps: Vec<Step>,
    /// The highest order, below the one asked for where the expansion was stopped.
    pub highest: u32,
}

impl ExactSeries {
    /// Rewrites every coefficient.
    pub fn change_coefficients(&mut self, change: &dyn Fn(&Polynomial) -> Polynomial) {
        let series = |series: &FourierSeries<Polynomials>| {
            series.map(POLYNOMIALS, |coefficient, _| change(coefficient))
        };
        self.frequency = change(&self.frequency);
        self.frequency_squared = change(&self.frequency_squared);
        self.displacement = series(&self.displacement);
        for step in &mut self.steps {
            step.displacement = series(&step.displacement);
            step.resonance = change(&step.resonance);
            step.correction = change(&step.correction);
            if let Some(condition) = &mut step.amplitude {
                condition.sine = change(&condition.sine);
                if let Ok(Some(value)) = condition.value.to_polynomial(&mut |_| None) {
                    condition.value = Expr::from(&change(&value));
                }
            }
        }
    }
}

/// Expands to `order`; `terms` are in units of the amplitude and of the linear frequency, `delta`
/// marks the order of each term of the result, `inverse_slope` is as for
/// [`expand_from_root`](super::secular::expand_from_root), and no name in `taken` is used for
/// anything new. If the frequency alone is asked for, motion and steps are empty.
///
/// # Errors
/// See [`SecularError`].
pub fn expand_exactly(
    terms: &[Term],
    order: u32,
    scheme: &Scheme,
    delta: Option<Symbol>,
    inverse_slope: Option<&Polynomial>,
    (taken, extent): (&[Symbol], ExpansionScope),
    supervision: Supervision,
) -> Result<ExactSeries, SecularError> {
    let scales = scales(terms);
    let reduced: Vec<Term> = terms
        .iter()
        .map(|term| Term { coefficient: without(&term.coefficient, &scales), ..term.clone() })
        .collect();
    let restore = |n: usize| {
        let powers =
            scales.iter().map(|(symbol, rate)| (*symbol, rate * Rational::from_integer(n.into())));
        let start = delta.map_or_else(Monomial::one, |delta| Monomial::power_of(delta, n as i32));
        powers.filter(|(symbol, _)| Some(*symbol) != delta).fold(
            start,
            |monomial, (symbol, power)| {
                monomial
                    .product(&Monomial::power_of(symbol, power.to_integer().to_i32().unwrap_or(0)))
            },
        )
    };
    let numbers: Option<Vec<Rational>> =
        reduced.iter().map(|term| term.coefficient.as_number()).collect();
    match numbers {
        Some(numbers) if inverse_slope.is_none() => {
            let constant = |number: Rational| {
                FourierSeries::constant(Integers, number.numer().clone()).over(number.denom())
            };
            let force = force_terms(&reduced, numbers.into_iter().map(constant));
            let expansion =
                expand_numbers_supervised(&force, order as usize, scheme, extent, supervision)?;
            Ok(collect(&expansion, scheme, over_denominator::<Integer>, restore, taken))
        }
        _ => {
            let force =
                force_terms(&reduced, reduced.iter().map(|term| over_integers(&term.coefficient)));
            let expansion = match inverse_slope {
                None => expand_polynomials_supervised(
                    &force,
                    order as usize,
                    scheme,
                    extent,
                    supervision,
                )?,
                Some(inverse) => {
                    let inverse = over_integers(&without(inverse, &scales));
                    let ring = Polynomials(Integers);
                    let mut expansion = expand_supervised(
                        &ring,
                        &force,
                        order as usize,
                        scheme,
                        Some(inverse),
                        supervision,
                    )?;
                    if extent == ExpansionScope::Frequency {
                        expansion.forget_motion();
                    }
                    expansion
                }
            };
            Ok(collect(&expansion, scheme, over_denominator::<Polynomial<Integer>>, restore, taken))
        }
    }
}

/// A numerator of a series.
trait Numerator {
    /// Its polynomial, where `over` divides a number by the denominator of the series.
    fn polynomial(&self, over: &dyn Fn(&Integer) -> Rational) -> Polynomial;
}

impl Numerator for Integer {
    fn polynomial(&self, over: &dyn Fn(&Integer) -> Rational) -> Polynomial {
        Polynomial::constant(over(self))
    }
}

impl Numerator for Polynomial<Integer> {
    fn polynomial(&self, over: &dyn Fn(&Integer) -> Rational) -> Polynomial {
        self.map(over)
    }
}

/// Converts the numerators of a series over this denominator to polynomials. The denominators of an
/// expansion have small prime factors alone: found once, they take the place of a greatest common
/// divisor for each coefficient.
fn over_denominator<N: Numerator>(denominator: &Integer) -> impl Fn(&N) -> Polynomial + use<'_, N> {
    let factored = Factored::factorize(denominator);
    move |numerator| {
        numerator.polynomial(&|number| match &factored {
            Some(factored) => factored.fraction(number, denominator),
            None => Rational::new(number.clone(), denominator.clone()),
        })
    }
}

/// Returns a series over whole coefficients with polynomials over fractions instead.
pub(super) fn to_fractions(
    series: &FourierSeries<Polynomials<Integers>>,
) -> FourierSeries<Polynomials> {
    let convert = over_denominator::<Polynomial<Integer>>(series.mean().1);
    series.map(POLYNOMIALS, |numerator, _| convert(numerator))
}

fn force_terms<R: Ring>(
    terms: &[Term],
    coefficients: impl Iterator<Item = FourierSeries<R>>,
) -> Vec<ForceTerm<R>> {
    let pairs = terms.iter().zip(coefficients);
    let force = |(term, coefficient): (&Term, _)| ForceTerm {
        order: term.order,
        position: term.position,
        velocity: term.velocity,
        coefficient,
    };
    pairs.map(force).collect()
}

/// A polynomial as whole coefficients over one denominator.
pub(super) fn over_integers(polynomial: &Polynomial) -> FourierSeries<Polynomials<Integers>> {
    let common = polynomial
        .terms()
        .fold(Integer::one(), |lcm, (_, coefficient)| lcm.lcm(coefficient.denom()));
    let numerators = polynomial.map(|coefficient| (coefficient * &common).to_integer());
    FourierSeries::constant(Polynomials(Integers), numerators).over(&common)
}

/// Every symbol whose exponent is the same multiple of the order in all terms, with that multiple:
/// such a symbol enters the result in step with the small parameter and can be left out while
/// expanding.
fn scales(terms: &[Term]) -> Vec<(Symbol, Rational)> {
    let symbols: BTreeSet<Symbol> =
        terms.iter().flat_map(|term| term.coefficient.symbols()).collect();
    let rate = |symbol: Symbol| {
        let rates: BTreeSet<Rational> = terms
            .iter()
            .flat_map(|term| {
                let exponents =
                    term.coefficient.terms().map(move |(monomial, _)| monomial.exponent(symbol));
                exponents.map(|exponent| ratio(exponent.into(), term.order as i64))
            })
            .collect();
        if rates.len() == 1 { rates.into_iter().next() } else { None }
    };
    symbols.into_iter().filter_map(|symbol| Some((symbol, rate(symbol)?))).collect()
}

fn without(coefficient: &Polynomial, scales: &[(Symbol, Rational)]) -> Polynomial {
    let mut reduced = Polynomial::zero();
    for (monomial, number) in coefficient.terms() {
        let rest =
            scales.iter().fold(monomial.clone(), |monomial, (symbol, _)| monomial.without(*symbol));
        reduced.add_term(rest, number.clone());
    }
    reduced
}

/// Orders `0, 1, ...` put together as polynomials in the small parameter and the symbols that were
/// scaled away.
fn collect<'a, R: Ring, P: Fn(&R::Element) -> Polynomial>(
    expansion: &'a SecularExpansion<R>,
    scheme: &Scheme,
    over: impl Fn(&'a Integer) -> P,
    restore: impl Fn(usize) -> Monomial,
    taken: &[Symbol],
) -> ExactSeries {
    let letter = fresh_stem("B", taken);
    let exact = |series: &'a FourierSeries<R>, n: usize| {
        let monomial = restore(n);
        let polynomial = over(series.mean().1);
        series.map(POLYNOMIALS, |numerator, _| polynomial(numerator).times_monomial(&monomial))
    };
    let orders = |series: &'a [FourierSeries<R>]| -> Vec<FourierSeries<Polynomials>> {
        series.iter().enumerate().map(|(n, series)| exact(series, n)).collect()
    };
    let sum = |orders: &[FourierSeries<Polynomials>]| {
        let zero = FourierSeries::zero(POLYNOMIALS);
        orders.iter().fold(zero, |sum, term| sum.sum(term))
    };
    let constant = |series: &'a FourierSeries<R>, n: usize| exact(series, n).constant_term();
    let displacement = orders(&expansion.displacement);
    let amplitude = |n: usize| {
        let fixed = expansion.amplitudes.get(n.checked_sub(1)?)?;
        let unknown = Symbol::new(&format!("{letter}{n}"));
        let mut sine = constant(&fixed.slope, 1).product(&Polynomial::symbol(unknown));
        sine.accumulate(&constant(&fixed.sine, n + 1));
        Some(AmplitudeCondition {
            sine,
            unknown,
            value: Expr::from(&constant(&fixed.amplitude, n)),
        })
    };
    let step = |n: usize| {
        let correction = match n {
            0 => Polynomial::zero(),
            _ => constant(&expansion.frequency_squared[n], n),
        };
        let mut resonance = correction.clone();
        resonance.negate();
        Step {
            order: n as u32,
            resonance,
            correction,
            conditions: conditions(n, scheme),
            displacement: displacement[n].clone(),
            amplitude: amplitude(n),
        }
    };
    ExactSeries {
        frequency: sum(&orders(&expansion.frequency)).constant_term(),
        frequency_squared: sum(&orders(&expansion.frequency_squared)).constant_term(),
        steps: (0..displacement.len()).map(step).collect(),
        displacement: sum(&displacement),
        highest: expansion.frequency.len().saturating_sub(1) as u32,
    }
}

/// The conditions that fix `y_n`, beside the amplitude condition of a limit cycle.
fn conditions(n: usize, scheme: &Scheme) -> Vec<Condition> {
    match (n, scheme.normalisation, scheme.amplitude) {
        (0, ..) => vec![Condition::Position(1), Condition::AtRest],
        (_, AmplitudeConvention::Initial, AmplitudeKind::Free) => {
            vec![Condition::Position(0), Condition::AtRest]
        }
        (_, AmplitudeConvention::Initial, AmplitudeKind::Determined) => vec![Condition::AtRest],
        (_, AmplitudeConvention::FirstHarmonic, AmplitudeKind::Free) => {
            vec![Condition::NoCosine, Condition::NoSine]
        }
        (_, AmplitudeConvention::FirstHarmonic, AmplitudeKind::Determined) => {
            vec![Condition::NoSine]
        }
    }
}

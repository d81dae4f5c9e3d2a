//! An expression of the time as a finite Fourier series: `cos(m*Omega*t)`, `sin(m*Omega*t)`, their
//! products and powers.
//!
//! In: an expression with symbols for its parameters. Out: its exact series in `phi = Omega*t/2`,
//! where the coefficients have even harmonics and motions of twice their period have odd ones. The
//! error is the first term that is not such a sum.

use std::convert::Infallible;

use num_integer::Integer as _;
use num_traits::{Signed, ToPrimitive, Zero};

use crate::exact::rational::{Integer, ratio};
use crate::exact::{Monomial, POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::{Expr, Function, Node};
use crate::series::FourierSeries;
use crate::symbol::Symbol;

/// Largest number of harmonics of a coefficient.
const MOST_HARMONICS: usize = 200;

/// The highest power of a sum of waves that is written out.
const HIGHEST_POWER: u32 = 40;

/// The angular frequency of which all waves are multiples: `number * unit`, where the unit is a
/// product of symbols, or one.
#[derive(Clone, Debug, PartialEq)]
pub struct Frequency {
    /// The numerical factor, positive.
    pub number: Rational,
    /// The product of symbols.
    pub unit: Monomial,
}

impl Frequency {
    /// The frequency as a polynomial.
    pub fn polynomial(&self) -> Polynomial {
        Polynomial::term(self.unit.clone(), self.number.clone())
    }

    /// Returns n if `rate` is n times this frequency, n a whole number.
    fn multiple(&self, rate: &Rational) -> Option<usize> {
        let multiple = rate / &self.number;
        multiple.is_integer().then(|| multiple.to_integer().to_usize())?
    }
}

/// `rate` in the argument `rate*t` of a wave: its numerical factor and its product of symbols.
fn rate(argument: &Expr) -> Option<(Rational, Monomial)> {
    let time = Symbol::new("t");
    let polynomial = argument.to_polynomial(&mut |_| None).ok()??;
    let (monomial, number) = polynomial.single_term()?;
    (monomial.exponent(time) == 1).then(|| (number.clone(), monomial.without(time)))
}

/// The largest number of which both are multiples.
fn common(a: &Rational, b: &Rational) -> Rational {
    let numerator = (a.numer() * b.denom()).gcd(&(b.numer() * a.denom()));
    Rational::new(numerator, a.denom() * b.denom())
}

/// The frequency of all waves in these expressions; `None` if no wave occurs.
///
/// # Errors
/// A wave whose argument is not a multiple of time, or whose frequency has no common unit with
/// those before it.
pub fn frequency<'a>(
    expressions: impl IntoIterator<Item = &'a Expr>,
) -> Result<Option<Frequency>, Expr> {
    let mut found: Option<Frequency> = None;
    for expression in expressions {
        for wave in waves(expression) {
            let Some((number, unit)) = wave.children().next().and_then(rate) else {
                return Err(wave);
            };
            let number = number.abs();
            found = Some(match found {
                None => Frequency { number, unit },
                Some(known) if known.unit == unit => {
                    Frequency { number: common(&known.number, &number), unit }
                }
                Some(_) => return Err(wave),
            });
        }
    }
    Ok(found)
}

/// Every `sin` and `cos` of the time.
fn waves(expression: &Expr) -> Vec<Expr> {
    let time = Symbol::new("t");
    let is_wave =
        |part: &&Expr| matches!(part.node(), Node::Function(Function::Sin | Function::Cos, _));
    let waves = expression.unique_nodes().filter(is_wave);
    waves.filter(|wave| wave.contains(time)).cloned().collect()
}

/// The series in `phi = Omega*t/2`.
///
/// # Errors
/// The first term of the expression that is not a sum of waves with polynomial coefficients.
pub fn series(
    expression: &Expr,
    frequency: &Frequency,
) -> Result<FourierSeries<Polynomials>, Expr> {
    let term = |term: &Expr| {
        let series = term.fold(|part, parts: &[Option<FourierSeries<Polynomials>>]| {
            Ok::<_, Infallible>(series_of(part, parts, frequency))
        });
        let Ok(series) = series;
        series.ok_or_else(|| term.clone())
    };
    let zero = FourierSeries::zero(POLYNOMIALS);
    expression.terms().iter().try_fold(zero, |sum, part| Ok(sum.sum(&term(part)?)))
}

/// The series of an expression, given those of its parts; `None` for a part without a series, such
/// as the argument of a wave.
fn series_of(
    part: &Expr,
    parts: &[Option<FourierSeries<Polynomials>>],
    frequency: &Frequency,
) -> Option<FourierSeries<Polynomials>> {
    let constant = |value: Polynomial| FourierSeries::constant(POLYNOMIALS, value);
    if !part.contains(Symbol::new("t")) {
        return part.to_polynomial(&mut |_| None).ok().flatten().map(constant);
    }
    let mut all = parts.iter().map(Option::as_ref);
    let series = match part.node() {
        Node::Sum(_) => {
            all.try_fold(FourierSeries::zero(POLYNOMIALS), |sum, part| Some(sum.sum(part?)))?
        }
        Node::Product(number, _) => {
            let number = constant(Polynomial::constant(number.clone()));
            all.try_fold(number, |product, part| Some(product.product(part?)))?
        }
        Node::Power(_, exponent) => {
            let exponent = exponent.as_number().filter(|number| number.is_integer())?;
            let exponent =
                exponent.to_integer().to_u32().filter(|power| *power <= HIGHEST_POWER)?;
            all.next()??.power(exponent)
        }
        Node::Function(function, arguments) => {
            let (number, _) = rate(arguments.first()?)?;
            let harmonic = 2 * frequency.multiple(&number.abs())?;
            if harmonic > 2 * MOST_HARMONICS {
                return None;
            }
            match function {
                Function::Cos => FourierSeries::cos(POLYNOMIALS, harmonic),
                Function::Sin if number.is_negative() => {
                    FourierSeries::sin(POLYNOMIALS, harmonic).times(-1)
                }
                Function::Sin => FourierSeries::sin(POLYNOMIALS, harmonic),
                _ => return None,
            }
        }
        Node::Symbol(_) | Node::Number(_) | Node::Pi => return None,
    };
    (series.highest_harmonic() <= 2 * MOST_HARMONICS).then_some(series)
}

/// The coefficients with their shortest period: that of `cos(t)^2` is pi.
pub(super) fn in_lowest_terms(
    frequency: Frequency,
    series: [FourierSeries<Polynomials>; 2],
) -> (Frequency, [FourierSeries<Polynomials>; 2]) {
    let harmonics = series.iter().flat_map(FourierSeries::harmonics).map(|(harmonic, ..)| harmonic);
    let common = harmonics.fold(0_usize, |common, harmonic| common.gcd(&harmonic)) / 2;
    if common < 2 {
        return (frequency, series);
    }
    let shortened = series.map(|series| {
        let part = |of: &dyn Fn(usize) -> Polynomial| {
            (0..=series.highest_harmonic() / common).map(|k| of(k * common)).collect()
        };
        let cosines: Vec<Polynomial> = part(&|k| series.cosine(k).constant_term());
        let sines: Vec<Polynomial> = part(&|k| series.sine(k).constant_term());
        FourierSeries::from_parts(POLYNOMIALS, cosines, sines)
    });
    let frequency =
        Frequency { number: frequency.number * fraction(common, 1), unit: frequency.unit };
    (frequency, shortened)
}

/// A fraction of two whole numbers.
pub(super) fn fraction(numerator: usize, denominator: i64) -> Rational {
    Rational::from_integer(Integer::from(numerator)) * ratio(1, denominator)
}

/// Whether a series is zero.
pub(super) fn is_constant(series: &FourierSeries<Polynomials>) -> bool {
    series.highest_harmonic().is_zero()
}

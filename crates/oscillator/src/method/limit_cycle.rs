//! Self-excited oscillators: the amplitudes that the equation itself determines.
//!
//! Reference: A. H. Nayfeh, *Perturbation Methods*, Wiley 1973, sections 3.1 and 5.1.
//!
//! To first order the secular sine determines the rate of the amplitude. In units of the linear
//! frequency, with `z = a^2` and the terms `C_j` of the method of Lindstedt and Poincare,
//!
//! ```text
//! a' = delta a g(a^2)/2,      g(z) = sum_j c_j omega0^(q-2) [cos^p (-sin)^q]_sin z^((p+q-1)/2)
//! ```
//!
//! A positive root of `g` is the square of the amplitude of a limit cycle; it attracts where `delta
//! g' < 0`, and no expansion starts from a root at which `g'` vanishes too. At the orders above,
//! the amplitude of each follows from a linear equation with the one slope `J = -2 z g'(z)`.
//!
//! An amplitude that is neither a fraction nor a product of parameters enters as a symbol `a0`.
//! All coefficients stay exact if `a0^2` is the root of a polynomial with rational coefficients:
//! powers of `a0` are reduced, and `1/J` is found, modulo that polynomial.

use num_integer::Integer as _;
use num_traits::{One, Signed, ToPrimitive, Zero};

use super::{Reason, Refusal};
use crate::decimal::rounded;
use crate::derivation::AmplitudeCondition;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::{power, ratio};
use crate::exact::real_roots::{RealRoot, derivative, inverse_modulo, positive_roots, remainder};
use crate::exact::{Polynomial, Polynomials, Rational, Rationals};
use crate::expr::Expr;
use crate::oscillator::PerturbedForce;
use crate::series::FourierSeries;
use crate::solution::{AmplitudeConvention, Definition, LeadingCycle, Note};
use crate::symbol::letters::FIRST_HARMONIC;
use crate::symbol::{Symbol, fresh};

/// The equation `g(z) = 0` for the square of the amplitude.
pub(super) struct AmplitudeEquation {
    /// Greatest common divisor of all coefficients, with every symbol in it.
    factor: Monomial,
    /// The power of `z` that multiplies the rest.
    lowest: i32,
    /// The coefficients of the rest, lowest power first; the first is not zero.
    rest: Vec<Polynomial>,
}

/// A limit cycle to leading order, ready to be expanded from.
#[derive(Clone)]
pub(super) struct Cycle {
    /// The amplitude.
    pub amplitude: Expr,
    /// A polynomial that is positive if the cycle attracts and negative if it repels; `None` if the
    /// slope vanishes.
    pub attracts_where: Option<Polynomial>,
    /// The amplitude as a single term: a number, a product of parameters, or `a0`.
    pub unit: Polynomial,
    /// The definition of `a0`.
    pub definition: Option<Definition>,
    /// `1/J`, where an expansion cannot find it by itself.
    pub inverse_slope: Option<Polynomial>,
    /// A remark on the amplitude.
    pub remark: Option<Note>,
    relation: Option<PowerRelation>,
}

/// `symbol^degree = value`, with lower powers of the symbol in `value`.
#[derive(Clone)]
struct PowerRelation {
    symbol: Symbol,
    degree: i32,
    value: Polynomial,
}

impl AmplitudeEquation {
    /// `None` if the first order has no secular sine at any amplitude: the amplitude is free.
    pub fn new(force: &PerturbedForce, units: &FrequencyUnits) -> Option<Self> {
        let equation = coefficients(force, units);
        let lowest = equation.iter().position(|coefficient| !coefficient.is_zero())?;
        let factor = common_monomial(&equation);
        let inverse = factor.power(-1);
        let rest = equation[lowest..].iter().map(|entry| entry.times_monomial(&inverse));
        Some(Self { factor, lowest: lowest as i32, rest: rest.collect() })
    }

    /// Whether the equation is a single term, so that it has no root but zero.
    pub fn is_single_term(&self) -> bool {
        self.rest.len() < 2
    }

    /// The equation in `z`, for messages.
    pub fn in_square(&self, z: Symbol) -> Polynomial {
        let term = |(k, coefficient): (usize, &Polynomial)| {
            coefficient.times_monomial(&Monomial::power_of(z, k as i32))
        };
        let terms = self.rest.iter().enumerate().map(term);
        terms.fold(Polynomial::zero(), |sum, term| sum + term)
    }

    /// The secular sine of the first order, which vanishes at the amplitude `unknown` of the cycle.
    pub fn condition(
        &self,
        cycle: &Cycle,
        unknown: Symbol,
        marker: Option<Symbol>,
    ) -> AmplitudeCondition {
        let mark = marker.map_or_else(Monomial::one, |name| Monomial::power_of(name, 1));
        let mut sine = Polynomial::zero();
        for (k, coefficient) in self.rest.iter().enumerate() {
            let power = Monomial::power_of(unknown, 2 * (self.lowest + k as i32));
            sine.accumulate(
                &coefficient.times_monomial(&power.product(&mark).product(&self.factor)),
            );
        }
        sine.negate();
        AmplitudeCondition { sine, unknown, value: cycle.amplitude.clone() }
    }

    /// All limit cycles, smallest amplitude first: empty if the motion dies out or grows.
    ///
    /// # Errors
    /// The reason why the equation cannot be solved.
    pub fn cycles(
        &self,
        delta: Symbol,
        linear_frequency: &Polynomial,
        taken: &[Symbol],
    ) -> Result<Vec<Cycle>, &'static str> {
        let name = fresh(&format!("{FIRST_HARMONIC}0"), taken);
        let signs = self.factor.product(&Monomial::power_of(delta, 1));
        let signs = sign_of(&signs, linear_frequency);
        let numbers: Option<Vec<Rational>> = self.rest.iter().map(Polynomial::as_number).collect();
        if let Some(numbers) = numbers {
            let roots = positive_roots(&numbers);
            return Ok(roots
                .iter()
                .map(|root| self.numerical(root, &numbers, [name, fresh("z", taken)], &signs))
                .collect());
        }
        let powers: Vec<usize> =
            (1..self.rest.len()).filter(|&k| !self.rest[k].is_zero()).collect();
        match powers.as_slice() {
            [] => Ok(vec![]),
            [highest] => self.two_terms(*highest, name, &signs),
            _ => Err("whose roots depend on the values of its symbols"),
        }
    }

    /// The cycle at a root of an equation in numbers, with names for its amplitude and for the
    /// root.
    fn numerical(
        &self,
        root: &RealRoot,
        equation: &[Rational],
        [name, z]: [Symbol; 2],
        signs: &Monomial,
    ) -> Cycle {
        let slope = derivative(equation);
        let slope_value = slope
            .iter()
            .rev()
            .fold(0.0, |sum, c| sum * root.value + crate::exact::rational::to_f64(c));
        let sign =
            |positive: bool| Rational::from_integer(if positive { 1.into() } else { (-1).into() });
        let attracts_where =
            root.simple.then(|| Polynomial::term(signs.clone(), sign(slope_value < 0.0)));
        let degree = root.factor.len() as i32 - 1;
        if let Some(exact) = root.exact.as_ref().and_then(|exact| power(exact, &ratio(1, 2))) {
            return Cycle {
                amplitude: Expr::number(exact.clone()),
                attracts_where,
                unit: Polynomial::constant(exact),
                definition: None,
                inverse_slope: None,
                remark: None,
                relation: None,
            };
        }
        let radical = radical(root);
        let amplitude = radical.clone().unwrap_or_else(|| Expr::number(rounded(root.value.sqrt())));
        let remark = radical.is_none().then(|| {
            let term = |(k, c): (usize, &Rational)| {
                Polynomial::term(Monomial::power_of(z, k as i32), c.clone())
            };
            let terms = root.factor.iter().enumerate().map(term);
            Note::RoundedAmplitude {
                amplitude: name,
                square: z,
                polynomial: terms.fold(Polynomial::zero(), |sum, term| sum + term),
            }
        });
        // a0^(2 degree) = -(lower powers), and 1/J = -1/(2 z^(lowest + 1) h'(z)) modulo the factor.
        let in_name = |list: &[Rational]| {
            let term = |(k, c): (usize, &Rational)| {
                Polynomial::term(Monomial::power_of(name, 2 * k as i32), c.clone())
            };
            list.iter().enumerate().map(term).fold(Polynomial::zero(), |sum, term| sum + term)
        };
        let leading = &root.factor[degree as usize];
        let lower: Vec<Rational> =
            root.factor[..degree as usize].iter().map(|c| -(c / leading)).collect();
        let mut whole = vec![Rational::zero(); self.lowest as usize + 1];
        whole.extend(slope.iter().map(|c| c * ratio(-2, 1)));
        let inverse = inverse_modulo(&remainder(&whole, &root.factor), &root.factor);
        Cycle {
            attracts_where,
            unit: Polynomial::symbol(name),
            definition: Some(Definition { symbol: name, meaning: amplitude.clone() }),
            amplitude,
            inverse_slope: inverse
                .map(|list| in_name(&list).times_monomial(&self.factor.power(-1))),
            remark,
            relation: Some(PowerRelation {
                symbol: name,
                degree: 2 * degree,
                value: in_name(&lower),
            }),
        }
    }

    /// The cycle of `h_0 + h_m z^m` with symbols: `z^m = -h_0/h_m`, and `J = 2 m z^lowest h_0`
    /// there.
    fn two_terms(
        &self,
        highest: usize,
        name: Symbol,
        signs: &Monomial,
    ) -> Result<Vec<Cycle>, &'static str> {
        let (low, high) = (&self.rest[0], &self.rest[highest]);
        let m = highest as i32;
        let scale = |value: i64| Polynomial::constant(Rational::from_integer(value.into()));
        let times = |polynomial: &Polynomial, number: i64| polynomial.product(&scale(number));
        let ratio_of_terms = high.power(-1).map(|inverse| times(&low.product(&inverse), -1));
        let single = |polynomial: &Polynomial| {
            polynomial.single_term().map(|(monomial, number)| (monomial.clone(), number.clone()))
        };
        // z h'(z) = m h_m z^m = -m h_0: the form is used whose sign is that of a single term.
        let (direction, factor_of_slope, exponent) = match (single(low), single(high)) {
            (_, Some((monomial, number))) => {
                ((monomial, -number), times(high, -2 * i64::from(m)), self.lowest + m)
            }
            (Some(term), None) => (term, times(low, 2 * i64::from(m)), self.lowest),
            (None, None) => return Err("which divides by a sum of symbols"),
        };
        let (monomial, number) = direction;
        let attracts_where = Some(Polynomial::term(
            sign_of(&signs.product(&monomial), &Polynomial::zero()),
            number.signum(),
        ));
        let power_of_root = Expr::number(ratio(1, 2 * i64::from(m)));
        let root =
            |value: &Expr| Expr::power(value, &power_of_root).map_err(|_| "whose root is not real");
        let squared = ratio_of_terms.filter(|value| value.single_term().is_some());
        let Some(squared) = squared else {
            let quotient = Expr::divide(&-&Expr::from(low), &Expr::from(high))
                .map_err(|_| "which divides by zero")?;
            let amplitude = root(&quotient)?;
            let inverse = factor_of_slope.power(-1).ok_or("which divides by a sum of symbols")?;
            let inverse = inverse.times_monomial(&Monomial::power_of(name, -2 * exponent));
            return Ok(vec![Cycle {
                attracts_where,
                unit: Polynomial::symbol(name),
                definition: Some(Definition { symbol: name, meaning: amplitude.clone() }),
                amplitude,
                inverse_slope: Some(inverse.times_monomial(&self.factor.power(-1))),
                remark: None,
                relation: None,
            }]);
        };
        if squared.single_term().is_some_and(|(_, number)| !number.is_positive()) {
            return Ok(vec![]);
        }
        let exact = root_of_term(&squared, 2 * m);
        let amplitude = match &exact {
            Some(exact) => Expr::from(exact),
            None => root(&Expr::from(&squared))?,
        };
        let definition =
            exact.is_none().then(|| Definition { symbol: name, meaning: amplitude.clone() });
        Ok(vec![Cycle {
            amplitude,
            attracts_where,
            definition,
            inverse_slope: None,
            remark: None,
            relation: exact.is_none().then(|| PowerRelation {
                symbol: name,
                degree: 2 * m,
                value: squared,
            }),
            unit: exact.unwrap_or_else(|| Polynomial::symbol(name)),
        }])
    }
}

impl Cycle {
    /// A polynomial in which high powers of `a0` are replaced by lower ones.
    pub fn reduced(&self, polynomial: &Polynomial) -> Polynomial {
        let Some(PowerRelation { symbol, degree, value }) = &self.relation else {
            return polynomial.clone();
        };
        let mut reduced = polynomial.clone();
        let inverse = value.single_term().is_some().then(|| value.power(-1)).flatten();
        loop {
            let mut next = Polynomial::zero();
            let mut changed = false;
            for (monomial, number) in reduced.terms() {
                let exponent = monomial.exponent(*symbol);
                let (times, replaced) = match (&inverse, exponent) {
                    (Some(inverse), ..0) => (-*degree, inverse),
                    (_, exponent) if exponent >= *degree => (*degree, value),
                    _ => {
                        next.add_term(monomial.clone(), number.clone());
                        continue;
                    }
                };
                changed = true;
                let rest = monomial.product(&Monomial::power_of(*symbol, -times));
                next.accumulate(&Polynomial::term(rest, number.clone()).product(replaced));
            }
            reduced = next;
            if !changed {
                return reduced;
            }
        }
    }

    /// The cycle in the words of the answer, where `marker` stands for `small`.
    pub fn to_leading(&self, marker: Symbol, small: Symbol) -> LeadingCycle {
        let condition = self.attracts_where.as_ref().and_then(|condition| match marker == small {
            true => Some(condition.clone()),
            false => condition.substitute(marker, &Polynomial::constant(One::one())),
        });
        LeadingCycle {
            amplitude: self.amplitude.clone(),
            attracts_where: condition.map(|condition| Expr::from(&condition)),
        }
    }

    /// Whether it attracts for small positive values of everything.
    pub fn attracts(&self) -> bool {
        let term = self.attracts_where.as_ref().and_then(Polynomial::single_term);
        term.is_some_and(|(_, number)| number.is_positive())
    }
}

/// The linear frequency, in whose powers the terms are measured.
pub(super) struct FrequencyUnits {
    /// The linear frequency, a single term.
    pub frequency: Polynomial,
    /// Its square, where even powers are better written with it: `x'` and `x'^3` then have like
    /// terms.
    square: Option<Polynomial>,
}

impl FrequencyUnits {
    /// The square takes the place of even powers where it is a number, so that a letter such as
    /// `omega0 = sqrt(2)` stays out of the expansion, and where the equation for the amplitude has
    /// sums without it.
    pub fn new(force: &PerturbedForce, frequency: Polynomial) -> Self {
        let plain = Self { frequency, square: None };
        let known = force.linear.symbols();
        let named = force.definitions.iter().any(|definition| known.contains(&definition.symbol));
        let sums =
            || coefficients(force, &plain).iter().any(|coefficient| coefficient.terms().len() > 1);
        let is_number = force.linear.as_number().is_some() && plain.frequency.as_number().is_none();
        match is_number || (!named && force.linear.single_term().is_some() && sums()) {
            true => Self { square: Some(force.linear.clone()), ..plain },
            false => plain,
        }
    }

    /// `omega0^exponent`.
    pub fn power_of_frequency(&self, exponent: i32) -> Polynomial {
        let halves = exponent.div_euclid(2);
        let power = match &self.square {
            None => self.frequency.power(exponent),
            // An odd power is one below the next even one, so that a factor 1/omega0 is common to
            // all damping terms.
            Some(square) if exponent.is_odd() => square
                .power(halves + 1)
                .and_then(|even| Some(even.product(&self.frequency.power(-1)?))),
            Some(square) => square.power(halves),
        };
        power.unwrap_or_else(Polynomial::zero)
    }
}

/// The number of the cycle to expand from: the one asked for, else the smallest that attracts for
/// small positive parameters, else the smallest.
///
/// # Errors
/// The error `none` if there is no cycle; a number that is too large.
pub(super) fn chosen(
    cycles: &[Cycle],
    asked: Option<u32>,
    none: impl Fn() -> Refusal,
) -> Result<usize, Refusal> {
    if cycles.is_empty() {
        return Err(none());
    }
    let Some(asked) = asked else {
        let simple = |cycle: &Cycle| cycle.attracts_where.is_some();
        let place =
            cycles.iter().position(Cycle::attracts).or_else(|| cycles.iter().position(simple));
        return Ok(place.unwrap_or(0) + 1);
    };
    match usize::try_from(asked) {
        Ok(number) if (1..=cycles.len()).contains(&number) => Ok(number),
        _ => Err(Reason::NoSuchCycle(asked, cycles.len()).into()),
    }
}

/// The amplitude of a motion in a convention.
pub(super) fn amplitude_of(
    displacement: &FourierSeries<Polynomials>,
    convention: AmplitudeConvention,
) -> Polynomial {
    match convention {
        AmplitudeConvention::Initial => displacement.at_zero().constant_term(),
        AmplitudeConvention::FirstHarmonic => displacement.cosine(1).constant_term(),
    }
}

/// `g_k`, the coefficients of `z^k` in the secular sine over the amplitude.
fn coefficients(force: &PerturbedForce, units: &FrequencyUnits) -> Vec<Polynomial> {
    let mut equation: Vec<Polynomial> = vec![];
    let first = force.terms.iter().filter(|term| term.order == 1 && term.velocity % 2 == 1);
    for term in first {
        let sine = FourierSeries::cos(Rationals, 1)
            .power(term.position)
            .product(&FourierSeries::sin(Rationals, 1).times(-1).power(term.velocity))
            .sine(1);
        let (weight, _) = sine.mean();
        if weight.is_zero() {
            continue;
        }
        let power = ((term.position + term.velocity).saturating_sub(1) / 2) as usize;
        if equation.len() <= power {
            equation.resize(power + 1, Polynomial::zero());
        }
        let frequency = units.power_of_frequency(term.velocity as i32 - 2);
        let weighted = term.coefficient.product(&frequency).product(&Polynomial::constant(weight));
        equation[power].accumulate(&weighted);
    }
    while equation.last().is_some_and(Zero::is_zero) {
        equation.pop();
    }
    equation
}

/// The product of the lowest powers of every symbol over all terms.
fn common_monomial(polynomials: &[Polynomial]) -> Monomial {
    let terms = || {
        polynomials.iter().flat_map(|polynomial| polynomial.terms().map(|(monomial, _)| monomial))
    };
    let symbols: std::collections::BTreeSet<Symbol> =
        polynomials.iter().flat_map(Polynomial::symbols).collect();
    symbols.into_iter().fold(Monomial::one(), |common, symbol| {
        let lowest = terms().map(|monomial| monomial.exponent(symbol)).min().unwrap_or(0);
        common.product(&Monomial::power_of(symbol, lowest))
    })
}

/// The factors of a monomial that decide its sign: odd powers, but not of the linear frequency,
/// which is positive.
fn sign_of(monomial: &Monomial, linear_frequency: &Polynomial) -> Monomial {
    let positive = linear_frequency.symbols();
    let odd = monomial
        .factors()
        .iter()
        .filter(|(symbol, exponent)| exponent.is_odd() && !positive.contains(symbol));
    odd.fold(Monomial::one(), |sign, (symbol, _)| sign.product(&Monomial::power_of(*symbol, 1)))
}

/// The exact `degree`-th root of a single term.
fn root_of_term(term: &Polynomial, degree: i32) -> Option<Polynomial> {
    let (monomial, number) = term.single_term()?;
    let number = power(number, &ratio(1, degree.into()))?;
    let mut root = Monomial::one();
    for &(symbol, exponent) in monomial.factors() {
        if exponent % degree != 0 {
            return None;
        }
        root = root.product(&Monomial::power_of(symbol, exponent / degree));
    }
    Some(Polynomial::term(root, number))
}

/// The square root of a root in radicals, where its factor is linear or quadratic in a power of z.
fn radical(root: &RealRoot) -> Option<Expr> {
    let factor = &root.factor;
    let nonzero = (1..factor.len()).filter(|&k| !factor[k].is_zero());
    let step = nonzero.fold(0, |step: usize, k| step.gcd(&k));
    let coefficient = |k: usize| factor.get(k * step);
    let degree = factor.len().checked_sub(1)?.checked_div(step)?;
    let leading = coefficient(degree)?;
    let power_of_z = match degree {
        1 => Expr::number(-(coefficient(0)? / leading)),
        2 => {
            let half = coefficient(1)? / leading * ratio(-1, 2);
            let square = &half * &half - coefficient(0)? / leading;
            let middle = crate::exact::rational::to_f64(&half);
            let sign = if root.value.powi(step.to_i32()?) > middle { 1 } else { -1 };
            let surd = Expr::number(square).sqrt().ok()?;
            &Expr::number(half) + &(&Expr::from(sign) * &surd)
        }
        _ => return None,
    };
    Expr::power(&power_of_z, &Expr::number(ratio(1, 2 * step.to_i64()?))).ok()
}

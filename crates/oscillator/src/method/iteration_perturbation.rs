//! Iteration perturbation: the nonlinear factor frozen at the previous iterate.
//!
//! Reference: J.-H. He, *Iteration perturbation method for strongly nonlinear oscillations*, J.
//! Vib. Control 7 (2001) 631-642; the second and later passes are the direct iteration of R. E.
//! Mickens, *Truly Nonlinear Oscillations*, World Scientific 2010, chapter 4.
//!
//! ```text
//! x_n'' + g(x_(n-1)) x_n = 0,   g(x) = f(x)/x,   x_0 = A cos(omega t)                (a Hill equation, as Mathieu's)
//! x_n'' + omega^2 x_n = omega^2 x_(n-1) - g(x_(n-1)) x_(n-1) = omega^2 x_(n-1) - f(x_(n-1))
//! no secular term fixes omega^2;   x_1 = A cos theta + sum_(k>1) c_k (cos k theta - cos theta)/((k^2 - 1) omega^2)
//! ```
//!
//! Cost: one Fourier table of the force for each pass; the number of terms of a pass grows as the
//! power of the degree of the force.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
//! let options = Options { method: Some(Method::IterationPerturbation), ..Options::default() };
//! let solution = solve(&pendulum, &options)?;
//! assert_eq!(solution.law.closed_form().unwrap().to_string(), "omega^2 = 2*J1(A)/A");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use num_traits::{One, Zero};

use super::one_term::{
    conservative_force, cosine, first_projection, law_of, note_even_part_last, solve_by_integral,
    unsolved,
};
use super::{Options, Reason, Refusal, not_polynomial};
use crate::conservative::projection::cosine_coefficient;
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::exact::polynomial::Monomial;
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::Expr;
use crate::oscillator::{Oscillator, OscillatorError};
use crate::series::FourierSeries;
use crate::series::fourier::linear_combination;
use crate::solution::note::Truncation;
use crate::solution::{Definition, Law, Method, Note, Solution};
use crate::symbol::letters::FREQUENCY;
use crate::symbol::{Symbol, fresh_stem};

const METHOD: Method = Method::IterationPerturbation;

/// The largest number of passes, with which the number of harmonics grows exponentially.
const MOST_PASSES: u32 = 3;

/// The most harmonics after the last pass of a polynomial force.
const MOST_HARMONICS: usize = 125;

/// Harmonics of the first iterate kept where the force has infinitely many.
const HIGHEST_HARMONIC: usize = 5;

/// Frequency and motion after this many passes, one by default.
///
/// # Errors
/// A force that is not conservative, by its term; above one pass, a force that is not a polynomial.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    let force = conservative_force(oscillator, options, METHOD)?;
    let passes = options.order.unwrap_or(1);
    if passes > MOST_PASSES {
        return Err(Reason::HighestOrder(MOST_PASSES).to(METHOD));
    }
    if passes > 1 {
        return iterated(oscillator, options, &force, passes);
    }
    let mut solution = solve_by_integral(oscillator, options, METHOD)?;
    first_iterate(&mut solution, oscillator, &force)?;
    solution.derivation = match polynomial_coefficients(oscillator, &force)? {
        Some(coefficients) => {
            let start = cosine(Polynomial::symbol(Symbol::new("A")));
            let mut lines = vec![DerivationLine::equation(numbered(oscillator, 0), start.clone())];
            lines.extend(
                IterationPass::new(oscillator, &coefficients, &start)?
                    .lines(oscillator, 1, None)?,
            );
            lines
        }
        None => frozen_function(oscillator, &force)?,
    };
    if let Some(law) = law_of(&solution) {
        let squared = Expr::symbol("omega").integer_power(2)?;
        solution.derivation.push(DerivationLine::equation(squared, law));
    }
    note_even_part_last(&mut solution);
    Ok(solution)
}

/// Sets the first iterate of an answer: its harmonics are exact for polynomials, the lowest of them
/// otherwise.
pub(super) fn first_iterate(
    solution: &mut Solution,
    oscillator: &Oscillator,
    force: &Expr,
) -> Result<(), Refusal> {
    let amplitude = Expr::symbol("A");
    let degree = oscillator.polynomial_degree()?.map(|degree| degree as usize);
    let highest = degree.unwrap_or(HIGHEST_HARMONIC);
    let stem = fresh_stem("c", &oscillator.names());
    let mut motion = solution.displacement.clone();
    for k in (0..=highest).filter(|&k| k != 1) {
        let Some(coefficient) = cosine_coefficient(force, oscillator.coordinate, &amplitude, k)
        else {
            return Ok(());
        };
        if coefficient.is_zero() {
            continue;
        }
        let mut polynomial = match coefficient.to_polynomial(&mut |_| None)? {
            Some(polynomial) => polynomial,
            None => {
                let symbol = Symbol::new(&format!("{stem}{k}"));
                solution.definitions.push(Definition { symbol, meaning: coefficient });
                Polynomial::symbol(symbol)
            }
        };
        // The constant term of the series is half of c_0.
        let divisor = if k == 0 { -2 } else { (k * k - 1) as i64 };
        polynomial = polynomial.times_monomial(&Monomial::power_of(Symbol::new("omega"), -2));
        let wave = linear_combination(
            &POLYNOMIALS,
            &[(1, &FourierSeries::cos(POLYNOMIALS, k)), (-1, &FourierSeries::cos(POLYNOMIALS, 1))],
        );
        let term = wave.product(&FourierSeries::constant(POLYNOMIALS, polynomial));
        motion = motion.sum(&term.divided_by(divisor));
    }
    if degree.is_none() && motion != solution.displacement {
        solution.validity.push(Note::MotionCutAfter { harmonic: highest });
    }
    solution.displacement = motion;
    Ok(())
}

/// Several passes for a polynomial force: an implicit relation in even powers of omega.
fn iterated(
    oscillator: &Oscillator,
    options: &Options,
    force: &Expr,
    passes: u32,
) -> Result<Solution, Refusal> {
    let (omega, amplitude) = (Symbol::new("omega"), Symbol::new("A"));
    let coefficients = polynomial_coefficients(oscillator, force)?
        .ok_or_else(|| not_polynomial(force, oscillator.coordinate, METHOD))?;
    // Every pass multiplies the number of harmonics by the degree.
    let degree = coefficients.len().saturating_sub(1);
    if degree.saturating_pow(passes) > MOST_HARMONICS {
        return Err(Reason::TooLong(MOST_TERMS).into());
    }
    let inverse = Monomial::power_of(omega, -2);
    let mut solution = unsolved(oscillator, options, METHOD, passes);
    let mut motion = cosine(Polynomial::symbol(amplitude));
    let mut secular = Polynomial::zero();
    let mut lines = vec![DerivationLine::equation(numbered(oscillator, 0), motion.clone())];
    for number in 1..=passes {
        let pass = IterationPass::new(oscillator, &coefficients, &motion)?;
        let (particular, resonance) = pass.right_side.solve_oscillator();
        secular = resonance.cosine.constant_term();
        let particular =
            particular.map(POLYNOMIALS, |coefficient, _| coefficient.times_monomial(&inverse));
        let rest = FourierSeries::constant(POLYNOMIALS, Polynomial::symbol(amplitude))
            .difference(&particular.at_zero());
        motion = particular.sum(&rest.product(&FourierSeries::cos(POLYNOMIALS, 1)));
        lines.extend(pass.lines(oscillator, number, (number < passes).then_some(&motion))?);
    }
    let relation = secular.times_monomial(&Monomial::power_of(amplitude, -1));
    let lowest = relation.exponent_range(omega).map_or(0, |range| range.0.min(0));
    solution.law = Law::Relation {
        relation: relation.times_monomial(&Monomial::power_of(omega, -lowest)),
        root: None,
    };
    solution.displacement = motion;
    solution.derivation = lines;
    solution.validity.push(Note::Cut(Truncation::Passes {
        passes,
        linear_frequency: Some(solution.linear_frequency_name()),
    }));
    Ok(solution)
}

/// One pass: the factor frozen at the motion before, and what it leaves on the right side.
struct IterationPass {
    factor: FourierSeries<Polynomials>,
    right_side: FourierSeries<Polynomials>,
}

impl IterationPass {
    fn new(
        oscillator: &Oscillator,
        coefficients: &[Polynomial],
        motion: &FourierSeries<Polynomials>,
    ) -> Result<Self, Refusal> {
        // f(0) = 0, so f/x is a polynomial as well.
        let quotient = coefficients.get(1..).unwrap_or_default();
        if coefficients.first().is_some_and(|constant| !constant.is_zero()) {
            return Err(OscillatorError::NoEquilibrium(oscillator.force.to_string()).into());
        }
        let factor = horner(quotient, motion)?;
        let squared =
            Polynomial::term(Monomial::power_of(Symbol::new("omega"), 2), Rational::one());
        let squared = FourierSeries::constant(POLYNOMIALS, squared);
        Ok(Self { right_side: squared.difference(&factor).product(motion), factor })
    }

    /// The pass as lines of a derivation; `next` is the name of the motion that it gives, if
    /// another pass follows.
    fn lines(
        &self,
        oscillator: &Oscillator,
        number: u32,
        next: Option<&FourierSeries<Polynomials>>,
    ) -> Result<Vec<DerivationLine>, Refusal> {
        let (before, after) = (numbered(oscillator, number - 1), numbered(oscillator, number));
        let omega = Expr::symbol("omega").integer_power(2)?;
        let x = Expr::from(oscillator.coordinate);
        let factor = Expr::divide(&oscillator.force, &x)?.expand()?;
        let factor = factor.substitute(oscillator.coordinate, &before.into())?;
        let left = DerivationFormula::oscillator(after, omega);
        let secular = self.right_side.cosine(1).constant_term();
        let mut lines = vec![
            DerivationLine::equation(factor, self.factor.clone())
                .because(format!("pass {number}, the factor frozen at {before}")),
            DerivationLine::equal([left, self.right_side.clone().into()]).because(format!(
                "{after}'' + {FREQUENCY}^2*{after} = ({FREQUENCY}^2 - factor)*{before}"
            )),
        ];
        let zero = Expr::zero();
        match next {
            Some(motion) => {
                lines.push(DerivationLine::equation(after, motion.clone()).because(format!(
                    "the secular term left out: {FREQUENCY} follows from the last pass"
                )));
            }
            None => lines
                .push(DerivationLine::equation(&secular, zero).because("no cos(θ) on the right")),
        }
        Ok(lines)
    }
}

/// `x0`, `x1`, ...; another stem where the equation uses one of these.
pub(super) fn numbered(oscillator: &Oscillator, number: u32) -> Symbol {
    let letter = fresh_stem(oscillator.coordinate.name(), &oscillator.names());
    Symbol::new(&format!("{letter}{number}"))
}

/// The first pass of a force that is not a polynomial.
fn frozen_function(oscillator: &Oscillator, force: &Expr) -> Result<Vec<DerivationLine>, Refusal> {
    let [start, first] = [0, 1].map(|number| numbered(oscillator, number));
    let along = Expr::symbol("A") * Expr::from(oscillator.phase()).cos()?;
    let factor = Expr::divide(force, &oscillator.coordinate.into())?;
    let frozen = factor.substitute(oscillator.coordinate, &along)?;
    let squared = Expr::symbol("omega").integer_power(2)?;
    Ok(vec![
        DerivationLine::equation(start, along),
        DerivationLine::equal([DerivationFormula::oscillator(first, frozen), Expr::zero().into()])
            .because(format!("the factor frozen at {start}")),
        DerivationLine::equation(squared, first_projection(oscillator, force)?)
            .because("no cos(θ) remains"),
    ])
}

/// The coefficients of a polynomial force, lowest power first; `None` for any other force.
pub(super) fn polynomial_coefficients(
    oscillator: &Oscillator,
    force: &Expr,
) -> Result<Option<Vec<Polynomial>>, Refusal> {
    let Some(polynomial) = force.to_polynomial(&mut |_| None)? else {
        return Ok(None);
    };
    let coordinate = oscillator.coordinate;
    let Some((0.., highest)) = polynomial.exponent_range(coordinate) else {
        return Ok(None);
    };
    let mut coefficients = vec![Polynomial::zero(); usize::try_from(highest).unwrap_or(0) + 1];
    for (monomial, number) in polynomial.terms() {
        let power = usize::try_from(monomial.exponent(coordinate)).unwrap_or(0);
        coefficients[power].add_term(monomial.without(coordinate), number.clone());
    }
    Ok(Some(coefficients))
}

/// The most terms of one coefficient before a pass is given up.
const MOST_TERMS: usize = 5000;

/// The force along a motion.
pub(super) fn horner(
    coefficients: &[Polynomial],
    motion: &FourierSeries<Polynomials>,
) -> Result<FourierSeries<Polynomials>, Refusal> {
    let mut value = FourierSeries::zero(POLYNOMIALS);
    for coefficient in coefficients.iter().rev() {
        value =
            value.product(motion).sum(&FourierSeries::constant(POLYNOMIALS, coefficient.clone()));
        let longest = value.harmonics().iter().map(|entry| entry.1.terms().len()).max();
        if longest.is_some_and(|longest| longest > MOST_TERMS) {
            return Err(Reason::TooLong(MOST_TERMS).into());
        }
    }
    Ok(value)
}

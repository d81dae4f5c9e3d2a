//! Harmonic balance: as many harmonics as wanted, each balanced.
//!
//! References: R. E. Mickens, *Truly Nonlinear Oscillations*, World Scientific 2010, chapter 3; M.
//! Krack, J. Gross, *Harmonic Balance for Nonlinear Vibration Problems*, Springer 2019, chapters 2
//! and 4 (sampling in time, continuation).
//!
//! ```text
//! x = sum_k a_k cos(k theta),   k = 1, 3, ..., 2n-1 for an odd force, 0, 1, ..., n otherwise,   A = sum_k a_k
//! -k^2 omega^2 a_k + c_k = 0,   c_k = (2/pi) int_0^pi f(x(theta)) cos(k theta) dtheta          (c_0 counts half)
//! ```
//!
//! One harmonic of an odd force is solved in closed form. Beyond that the system is printed, and
//! solved at an amplitude by [`balance`](super::balance::balance).
//!
//! Cost at an amplitude: a few Newton's steps, each with the samples of the force and a linear
//! system of `n` unknowns, at each point of a branch.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::HarmonicBalance), order: Some(2), ..Options::default() };
//! let solution = solve(&duffing, &options)?;
//! let system = solution.law.system().unwrap();
//! assert_eq!(system.equations.len(), 3); // two harmonics and A = a1 + a3
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use num_traits::{One, Zero};

use super::iteration_perturbation::{horner, polynomial_coefficients};
use super::one_term::{conservative_force, integral_law, set_law, shared_integral, unsolved};
use super::{Options, Reason, Refusal};
use crate::conservative::is_odd;
use crate::conservative::projection::cosine_coefficient;
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::exact::polynomial::Monomial;
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::{Expr, Function};
use crate::oscillator::Oscillator;
use crate::series::FourierSeries;
use crate::solution::{AlgebraicSystem, Law, Method, Note, Solution, note::ExactFirstStep};
use crate::symbol::{Symbol, fresh, fresh_stem};

const METHOD: Method = Method::HarmonicBalance;

/// The largest number of harmonics that may be balanced.
pub const MOST_HARMONICS: u32 = 100;

/// The longest system that is written out, in terms: fifteen harmonics of a cubic force. A longer
/// one is not readable.
const MOST_TERMS: usize = 3500;

/// The balance of this many harmonics, two by default.
///
/// # Errors
/// A force that is not conservative, by its term; no harmonics, or more than [`MOST_HARMONICS`].
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    let force = conservative_force(oscillator, options, METHOD)?;
    let order = options.order.unwrap_or(2);
    if order == 0 || order > MOST_HARMONICS {
        return Err(Reason::HighestOrder(MOST_HARMONICS).to(METHOD));
    }
    let odd = is_odd(&force, oscillator.coordinate)?;
    let mut solution = unsolved(oscillator, options, METHOD, order);
    if order == 1
        && odd
        && let Some(law) = shared_integral(oscillator, &force)
    {
        set_law(&mut solution, &law)?;
        solution.derivation =
            vec![DerivationLine::equation(oscillator.coordinate, solution.displacement.clone())];
        let law = integral_law(oscillator, &force, &solution)?;
        solution.derivation.extend(law);
        solution.validity.push(Note::FirstStep(ExactFirstStep::Harmonic));
        return Ok(solution);
    }
    let harmonics = harmonics(order, odd);
    let names = coefficient_names(oscillator, &harmonics);
    let mut cosine = vec![Polynomial::zero(); harmonics.last().map_or(0, |last| last + 1)];
    for (&k, &name) in harmonics.iter().zip(&names) {
        cosine[k] = Polynomial::symbol(name);
    }
    solution.displacement = FourierSeries::from_parts(POLYNOMIALS, cosine, vec![]);
    solution.derivation =
        projections(oscillator, &force, &harmonics, &names, &solution.displacement)?;
    match equations(oscillator, &force, &harmonics, &names, &solution.displacement)? {
        Some(equations) => {
            if equations.iter().any(|equation| equation.contains_function(Function::Acos)) {
                let first = harmonics.iter().zip(&names).find(|(k, _)| **k == 1);
                let first = first.map_or(Symbol::new("A"), |(_, name)| *name);
                solution.validity.push(Note::ArcsFor { positive: first });
            }
            let unknowns = std::iter::once(Symbol::new("omega")).chain(names).collect();
            solution.law = Law::System(AlgebraicSystem { unknowns, equations });
        }
        None => {
            solution.law = Law::Quadrature(solution.derivation.clone());
        }
    }
    solution.validity.push(Note::Balanced { harmonics, by_numbers: true });
    Ok(solution)
}

/// The balance of each harmonic as an integral over the force along the motion.
fn projections(
    oscillator: &Oscillator,
    force: &Expr,
    harmonics: &[usize],
    names: &[Symbol],
    motion: &FourierSeries<Polynomials>,
) -> Result<Vec<DerivationLine>, Refusal> {
    /// Number of harmonics beyond which one line stands for all.
    const MOST_LINES: usize = 8;
    let omega = Expr::symbol("omega").integer_power(2)?;
    let balance = |k: Expr, name: Expr, factor: i64| -> Result<DerivationLine, Refusal> {
        let integral = DerivationFormula::Integral {
            factor: Expr::divide(&Expr::from(factor), &Expr::pi())?,
            from: Expr::zero(),
            to: Expr::pi(),
            integrand: Box::new((force * &(&k * &Expr::from(oscillator.phase())).cos()?).into()),
            variable: oscillator.phase(),
        };
        Ok(DerivationLine::equation(k.integer_power(2)? * &omega * name, integral))
    };
    let mut lines = vec![DerivationLine::equation(oscillator.coordinate, motion.clone())];
    if harmonics.len() <= MOST_LINES {
        for (&k, &name) in harmonics.iter().zip(names) {
            let factor = if k == 0 { 1 } else { 2 };
            lines.push(
                balance(Expr::from(k as i64), name.into(), factor)?
                    .because(format!("harmonic {k}")),
            );
        }
    } else {
        let kept: Vec<String> = harmonics.iter().map(ToString::to_string).collect();
        let letter = names.last().map_or("a", |name| name.name());
        let letter = letter.trim_end_matches(|digit: char| digit.is_ascii_digit() || digit == '_');
        let taken = oscillator.names();
        let (k, coefficient) = (fresh("k", &taken), fresh(&format!("{letter}_k"), &taken));
        lines.push(
            balance(k.into(), coefficient.into(), 2)?
                .because(format!("harmonics {k} = {}", kept.join(", "))),
        );
    }
    lines
        .push(DerivationLine::equation("A", Expr::sum(names.iter().map(|name| Expr::from(*name)))));
    Ok(lines)
}

/// The harmonics of an order: odd ones of an odd force, else the mean and as many as the order says.
pub fn harmonics(order: u32, odd: bool) -> Vec<usize> {
    let order = order as usize;
    match odd {
        true => (0..order).map(|n| 2 * n + 1).collect(),
        false => (0..=order).collect(),
    }
}

/// `a1`, `a3`, ...; another stem where the equation uses one of these.
pub(super) fn coefficient_names(oscillator: &Oscillator, harmonics: &[usize]) -> Vec<Symbol> {
    let stem = fresh_stem("a", &oscillator.names());
    harmonics.iter().map(|k| Symbol::new(&format!("{stem}{k}"))).collect()
}

/// The balance of every harmonic and the amplitude condition, where the force allows it in closed
/// form.
fn equations(
    oscillator: &Oscillator,
    force: &Expr,
    harmonics: &[usize],
    names: &[Symbol],
    motion: &FourierSeries<Polynomials>,
) -> Result<Option<Vec<Expr>>, Refusal> {
    let inertia = |k: usize, name: Symbol| {
        let square = Polynomial::constant(-Rational::from_integer((k * k).into()));
        square
            .product(&Polynomial::symbol(name))
            .times_monomial(&Monomial::power_of(Symbol::new("omega"), 2))
    };
    let mut equations = Vec::new();
    if let Some(coefficients) = polynomial_coefficients(oscillator, force)? {
        // Roughly the number of terms in this power of a sum of so many harmonics.
        let degree = coefficients.len().saturating_sub(1) as u32;
        if harmonics.len().saturating_pow(degree) > MOST_TERMS {
            return Ok(None);
        }
        let along = horner(&coefficients, motion)?;
        for (&k, &name) in harmonics.iter().zip(names) {
            let coefficient = along.cosine(k);
            let (numerator, denominator) = coefficient.mean();
            let mut equation =
                numerator.map(|value| value / Rational::from_integer(denominator.clone()));
            equation.accumulate(&inertia(k, name));
            equations.push(Expr::from(&equation));
        }
    } else {
        // A mean and one harmonic: x = a0 + a1 cos theta in closed form.
        let (shift, amplitude) = match (harmonics, names) {
            ([0, 1], [a0, a1]) => (Expr::from(*a0), Expr::from(*a1)),
            ([1], [a1]) => (Expr::zero(), Expr::from(*a1)),
            _ => return Ok(None),
        };
        let moved = force
            .substitute(oscillator.coordinate, &(Expr::from(oscillator.coordinate) + shift))?;
        for (&k, &name) in harmonics.iter().zip(names) {
            let Some(coefficient) =
                cosine_coefficient(&moved, oscillator.coordinate, &amplitude, k)
            else {
                return Ok(None);
            };
            let half = if k == 0 { crate::exact::rational::ratio(1, 2) } else { Rational::one() };
            let balance = coefficient * Expr::number(half) + Expr::from(&inertia(k, name));
            equations.push(balance.expand()?);
        }
    }
    let sum = Expr::sum(names.iter().map(|&name| Expr::from(name)));
    equations.push(sum - Expr::symbol("A"));
    let length: usize = equations.iter().map(|equation| equation.terms().len()).sum();
    Ok((length <= MOST_TERMS).then_some(equations))
}

//! Homotopy analysis: a homotopy with a convergence-control parameter, in which the frequency is expanded as well.
//!
//! Reference: S. Liao, *Beyond Perturbation: Introduction to the Homotopy Analysis Method*, Chapman & Hall/CRC 2003, chapter
//! 7 (free oscillations); S. Liao, Int. J. Non-Linear Mech. 34 (1999) 759-778.
//!
//! ```text
//! N[u, w] = w^2 u'' + f(u),   L[u] = w_0^2 (u'' + u),   derivatives in theta,   u_0 = A cos theta
//! L[u_m - chi_m u_(m-1)] = hbar R_m,   R_m = coefficient of q^(m-1) in N[sum q^k u_k, sum q^k w_k],   chi_1 = 0, else 1
//! no secular term in R_m fixes w_(m-1);   u_m(0) = 0
//! omega = w_0 + w_1 + ...,   E(hbar) = (1/(2 pi)) int_0^(2 pi) N[u, omega]^2 dtheta smallest
//! ```
//!
//! With hbar = -1 this is the homotopy in which omega itself, not omega0^2, is expanded. Order 1 is `w_0` alone.
//!
//! ```
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::HomotopyAnalysis), ..Options::default() };
//! let solution = solve(&duffing, &options)?;
//! assert_eq!(solution.law.frequency().unwrap().to_string(), "w0 + 3*eps^2*hbar*A^4/(256*w0^3)");
//! assert_eq!(solution.definitions[0].meaning.to_string(), "sqrt(4 + 3*eps*A^2)/2");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use num_traits::{One, Zero};

use super::one_term::{conservative_force, cosine, unsolved};
use super::secular::SecularError;
use super::{Options, Refusal};
use crate::derivation::{Formula, Line};
use crate::exact::polynomial::Monomial;
use crate::exact::{Integer, Polynomial, Rational, Ring};
use crate::expr::{Expr, Node};
use crate::oscillator::{Oscillator, PerturbedForce, SmallParameter};
use crate::series::FourierSeries;
use crate::series::fourier::{linear_combination, sum_of_products};
use crate::solution::{Definition, Law, Method, Solution};
use crate::symbol::{Symbol, fresh, fresh_stem};

const METHOD: Method = Method::HomotopyAnalysis;

/// The highest order: coefficients are polynomials in hbar, A, w0 and the parameters.
const HIGHEST: u32 = 20;

/// The most terms of one coefficient before the derivation is given up.
const MOST_TERMS: usize = 20_000;

/// Above this power of the force, coefficients have hundreds of digits and are counted: so many products of them are the most.
const HIGH_POWER: usize = 30;
const MOST_PRODUCTS: usize = 1_000_000;

/// The name of the convergence-control parameter, with underscores behind it where the equation uses the name.
pub const HBAR: &str = "hbar";

/// The convergence-control parameter in an answer.
pub fn convergence_control(solution: &Solution) -> Symbol {
    fresh(HBAR, &solution.names())
}

/// Frequency and motion to an order in the embedding parameter; two by default.
///
/// # Errors
/// A force that is not conservative or has no Taylor series, by its term; an order above 20.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    conservative_force(oscillator, options, METHOD)?;
    let order = options.order.unwrap_or(2);
    if order == 0 || order > HIGHEST {
        return Err(Refusal::HighestOrder {
            method: METHOD.title(),
            highest: HIGHEST,
        });
    }
    let polynomial = oscillator.polynomial_degree()?;
    let degree = match polynomial {
        Some(degree) if options.taylor.is_none() => degree,
        _ => options.taylor.unwrap_or(2 * order + 1),
    };
    let force = oscillator.expand_with_any_stiffness(SmallParameter::Amplitude, degree.saturating_sub(1))?;
    let mut solution = unsolved(oscillator, options, METHOD, order);
    solution.definitions.clone_from(&force.definitions);
    let symbol = convergence_control(&solution);
    let hbar = match &options.hbar {
        None => Polynomial::symbol(symbol),
        Some(value) => match value.to_polynomial(&mut |_| None)? {
            Some(number) => number,
            None => Polynomial::symbol(symbol),
        },
    };
    let series = expand(&force, order as usize, hbar, &mut solution)?;
    let sum = |series: &[FourierSeries<Polynomial>]| {
        let terms: Vec<_> = series.iter().map(|term| (1, term)).collect();
        linear_combination(&terms)
    };
    solution.law = Law::Frequency(constant(&sum(&series.frequency)));
    solution.displacement = sum(&series.displacement);
    let embedding = fresh("q", &solution.names());
    solution.validity.push(match order {
        1 => format!("order 1: the first frequency alone, the terms without {embedding}"),
        _ => format!(
            "order {order}: the first frequency and {}, truncated after {embedding}^{}",
            corrections(order - 1),
            order - 1
        ),
    });
    if polynomial.is_none() {
        let line = format!("the force entered as its Taylor polynomial of degree {degree}");
        solution.validity.push(line);
    }
    if options.hbar.is_none() && order > 1 {
        solution.validity.push(format!(
            "{symbol} controls the convergence; numbers are given with the one of least squared residual"
        ));
    }
    Ok(solution)
}

fn corrections(count: u32) -> String {
    match count {
        1 => "one correction".to_owned(),
        _ => format!("{count} corrections"),
    }
}

struct Series {
    frequency: Vec<FourierSeries<Polynomial>>,
    displacement: Vec<FourierSeries<Polynomial>>,
}

fn expand(force: &PerturbedForce, order: usize, hbar: Polynomial, solution: &mut Solution) -> Result<Series, Refusal> {
    let amplitude = Symbol::new("A");
    let constant_series = |value: Polynomial| FourierSeries::constant(value, Integer::one());
    let highest_power = force.terms.iter().map(|term| term.position as usize).max().unwrap_or(1);
    let start = cosine(Polynomial::symbol(amplitude));
    // powers[j][k]: the coefficient of q^k in u^(j+1).
    let mut powers: Vec<Vec<FourierSeries<Polynomial>>> = vec![vec![]; highest_power];
    let mut displacement: Vec<FourierSeries<Polynomial>> = vec![start];
    let mut frequency: Vec<FourierSeries<Polynomial>> = Vec::new();
    let hbar = constant_series(hbar);
    let mut inverse = FourierSeries::zero();
    let mut linear = force.linear.clone();
    let names = solution.names();
    let [u, w, r] = ["u", "w", "R"].map(|letter| fresh_stem(letter, &names));
    let numbered = |letter: &str, number: usize| Symbol::new(&format!("{letter}{number}"));
    let (control, mut start_name) = (convergence_control(solution), numbered(&w, 0));
    let mut lines = vec![Line::equation(numbered(&u, 0), displacement[0].clone())];
    for m in 1..=order {
        extend_powers(&mut powers, &displacement, m - 1)?;
        let mut right_side = powers[0][m - 1].product(&constant_series(linear.clone()));
        for term in &force.terms {
            let power = &powers[term.position as usize - 1][m - 1];
            right_side = right_side.sum(&power.product(&constant_series(term.coefficient.clone())));
        }
        if m == 1 {
            // w_0^2 A = c_1
            let squared = constant(&right_side.cosine(1)).times_monomial(&Monomial::power_of(amplitude, -1));
            let first = linear_frequency(&squared, solution);
            // From here on omega0^2 = w_0^2 - (the rest of w_0^2), so that what cancels does so term by term.
            linear = squared.clone();
            linear.negate();
            linear.accumulate(&force.linear);
            linear.accumulate(&first.product(&first));
            inverse = first.inverse().map_or_else(FourierSeries::zero, |(unit, integer)| {
                FourierSeries::constant(unit, Integer::one()).divided_by(i64::try_from(&integer).unwrap_or(1))
            });
            let name = first.single_term().filter(|(_, number)| number.is_one());
            let name = name.and_then(|(monomial, _)| Some(monomial.factors().first()?.0));
            let name = name.filter(|name| solution.definitions.iter().any(|entry| entry.symbol == *name));
            let name = name.unwrap_or(start_name);
            start_name = name;
            let inertia = |square: Polynomial| displacement[0].times(-1).product(&constant_series(square));
            let unknown = inertia(Polynomial::term(Monomial::power_of(name, 2), Rational::one()));
            lines.extend(secular_lines(
                numbered(&r, m),
                &right_side.sum(&unknown),
                Expr::from(name).integer_power(2)?,
                &squared,
            ));
            right_side = right_side.sum(&inertia(first.product(&first)));
            frequency.push(constant_series(first));
        } else {
            right_side = right_side.sum(&inertia_without_last(&frequency, &displacement, m - 1));
            // -2 w_0 w_(m-1) A + r = 0
            let by_amplitude = constant_series(Polynomial::term(Monomial::power_of(amplitude, -1), Rational::one()));
            let next = right_side
                .cosine(1)
                .product(&inverse)
                .product(&by_amplitude)
                .divided_by(2);
            let name = numbered(&w, m - 1);
            let unknown = frequency[0]
                .product(&displacement[0])
                .product(&constant_series(Polynomial::symbol(name)))
                .times(-2);
            lines.extend(secular_lines(
                numbered(&r, m),
                &right_side.sum(&unknown),
                name.into(),
                &constant(&next),
            ));
            frequency.push(next);
        }
        if m == order {
            break;
        }
        // What is left of the first harmonic has been removed by w_(m-1).
        let (particular, _) = right_side.solve_oscillator();
        let scaled = particular.product(&hbar).product(&inverse).product(&inverse);
        let mut next = scaled.difference(&scaled.at_zero().product(&FourierSeries::cos(1)));
        if m > 1 {
            next = next.sum(&displacement[m - 1]);
        }
        let longest = next.harmonics().iter().map(|entry| entry.1.terms().len()).max();
        if longest.is_some_and(|longest| longest > MOST_TERMS) {
            return Err(Refusal::TooLong { terms: MOST_TERMS });
        }
        let (name, before, residual) = (numbered(&u, m), numbered(&u, m - 1), numbered(&r, m));
        let driven = next.sum(&next.derivative().derivative());
        let left = Formula::Oscillator {
            of: name,
            square: Expr::one(),
        };
        lines.push(Line::equal([left, driven.into()]).because(match m {
            1 => format!("{name}'' + {name} = {control}*{residual}/{start_name}^2"),
            _ => format!("{name}'' + {name} = {before}'' + {before} + {control}*{residual}/{start_name}^2"),
        }));
        let start = |derivatives| Formula::AtZero { of: name, derivatives };
        lines.push(Line::equal([start(0), start(1), Expr::zero().into()]));
        lines.push(Line::equation(name, next.clone()));
        displacement.push(next);
    }
    solution.derivation = lines;
    Ok(Series {
        frequency,
        displacement,
    })
}

/// `R_m` with the unknown frequency in it, and the condition that fixes that.
fn secular_lines(name: Symbol, residual: &FourierSeries<Polynomial>, unknown: Expr, value: &Polynomial) -> Vec<Line> {
    let secular = constant(&residual.cosine(1));
    vec![
        Line::equation(name, residual.clone()),
        Line::equation(&secular, Expr::zero()).because(format!("no cos(theta) in {name}")),
        Line::equation(unknown, value),
    ]
}

/// Adds the coefficient of q^k to every power of u.
///
/// # Errors
/// A high power would take far more algebra than anyone waits for.
fn extend_powers(
    powers: &mut [Vec<FourierSeries<Polynomial>>],
    displacement: &[FourierSeries<Polynomial>],
    k: usize,
) -> Result<(), SecularError> {
    let size = |series: &FourierSeries<Polynomial>| {
        let harmonics = series.harmonics();
        harmonics.iter().map(|entry| entry.1.terms().len()).sum::<usize>()
    };
    if powers.len() > HIGH_POWER {
        let products = |i: usize| {
            size(&displacement[i])
                * powers
                    .iter()
                    .map(|power| power.get(k - i).map_or(0, size))
                    .sum::<usize>()
        };
        if (1..=k).map(products).sum::<usize>() > MOST_PRODUCTS {
            let harmonics = displacement[k].highest_harmonic() + powers.len() - 1;
            let degree = u32::try_from(powers.len()).unwrap_or(u32::MAX);
            return Err(SecularError::TooManyHarmonics { degree, harmonics });
        }
    }
    for j in 0..powers.len() {
        let next = match j.checked_sub(1) {
            None => displacement[k].clone(),
            Some(lower) => {
                let pairs: Vec<_> = (0..=k).map(|i| (1, &displacement[i], &powers[lower][k - i])).collect();
                sum_of_products(&pairs)
            }
        };
        powers[j].push(next);
    }
    Ok(())
}

/// The coefficient of `q^k` in `w^2 u''` without the term of the unknown `w_k`.
fn inertia_without_last(
    frequency: &[FourierSeries<Polynomial>],
    displacement: &[FourierSeries<Polynomial>],
    k: usize,
) -> FourierSeries<Polynomial> {
    let squared = |n: usize| {
        let pairs: Vec<_> = (0..=n)
            .filter_map(|i| Some((1, frequency.get(i)?, frequency.get(n - i)?)))
            .collect();
        sum_of_products(&pairs)
    };
    let mut sum = FourierSeries::zero();
    for n in 0..=k {
        sum = sum.sum(&squared(n).product(&displacement[k - n].derivative().derivative()));
    }
    sum
}

/// `w_0` as a single term where its square has such a root, else as a symbol with its definition.
fn linear_frequency(squared: &Polynomial, solution: &mut Solution) -> Polynomial {
    if let Some(root) = squared.single_term_root() {
        return root;
    }
    let symbol = Symbol::new(&(fresh_stem("w", &solution.names()) + "0"));
    let square = Expr::from(squared);
    let meaning = match square.sqrt() {
        // A number under the root of a product is taken out of it.
        Ok(root) if !matches!(root.node(), Node::Number(_)) => root,
        _ => square,
    };
    solution.definitions.push(Definition { symbol, meaning });
    Polynomial::symbol(symbol)
}

fn constant(series: &FourierSeries<Polynomial>) -> Polynomial {
    let (numerator, denominator) = series.mean();
    let mut value = numerator;
    if !value.is_zero() {
        value.divide(denominator);
    }
    value
}

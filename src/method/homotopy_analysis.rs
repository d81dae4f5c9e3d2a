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

use num_traits::One;

use super::one_term::{conservative_force, cosine, unsolved};
use super::secular::SecularError;
use super::{Options, Refusal, Unsuited};
use crate::derivation::{Formula, Line};
use crate::exact::polynomial::Monomial;
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::{Expr, Node};
use crate::oscillator::{Oscillator, PerturbedForce, SmallParameter};
use crate::series::FourierSeries;
use crate::series::convolution::{self, Convolutions};
use crate::series::fourier::{linear_combination, sum_of_products};
use crate::solution::{Definition, Law, Method, Note, Solution};
use crate::symbol::{Symbol, fresh, fresh_stem};

const METHOD: Method = Method::HomotopyAnalysis;

/// The highest order: coefficients are polynomials in hbar, A, w0 and the parameters.
const HIGHEST: u32 = 20;

/// The most terms of one coefficient before the derivation is given up.
const MOST_TERMS: usize = 20_000;

/// Above this power of the force, coefficients have hundreds of digits and are counted: so many products of them are the most.
const HIGH_POWER: u32 = 30;
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
        return Err(Unsuited::HighestOrder { highest: HIGHEST }.to(METHOD));
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
    let sum = |series: &[FourierSeries<Polynomials>]| {
        let terms: Vec<_> = series.iter().map(|term| (1, term)).collect();
        linear_combination(&POLYNOMIALS, &terms)
    };
    solution.law = Law::Frequency(sum(&series.frequency).constant_term());
    solution.displacement = sum(&series.displacement);
    let embedding = fresh("q", &solution.names());
    solution.validity.push(Note::Corrections { order, embedding });
    if polynomial.is_none() {
        solution.validity.push(Note::TaylorPolynomial { degree });
    }
    if options.hbar.is_none() && order > 1 {
        solution.validity.push(Note::ConvergenceControl(symbol));
    }
    Ok(solution)
}

struct Series {
    frequency: Vec<FourierSeries<Polynomials>>,
    displacement: Vec<FourierSeries<Polynomials>>,
}

fn expand(force: &PerturbedForce, order: usize, hbar: Polynomial, solution: &mut Solution) -> Result<Series, Refusal> {
    let amplitude = Symbol::new("A");
    let constant_series = |value: Polynomial| FourierSeries::constant(POLYNOMIALS, value);
    let highest_power = force.terms.iter().map(|term| term.position).max().unwrap_or(1);
    let start = cosine(Polynomial::symbol(amplitude));
    let mut products = Convolutions::new(POLYNOMIALS);
    let motion = products.leaf();
    let powers: Vec<convolution::Node> = force
        .terms
        .iter()
        .map(|term| products.power(motion, term.position))
        .collect();
    powers.iter().for_each(|&power| products.require(power, order - 1));
    let mut squares = Squares::new(order - 1);
    let mut displacement: Vec<FourierSeries<Polynomials>> = vec![start];
    let mut accelerations: Vec<FourierSeries<Polynomials>> = Vec::new();
    let mut frequency: Vec<FourierSeries<Polynomials>> = Vec::new();
    let hbar = constant_series(hbar);
    let mut inverse = FourierSeries::zero(POLYNOMIALS);
    let mut linear = force.linear.clone();
    let names = solution.names();
    let [u, w, r] = ["u", "w", "R"].map(|letter| fresh_stem(letter, &names));
    let numbered = |letter: &str, number: usize| Symbol::new(&format!("{letter}{number}"));
    let (control, mut start_name) = (convergence_control(solution), numbered(&w, 0));
    let mut lines = vec![Line::equation(numbered(&u, 0), displacement[0].clone())];
    for m in 1..=order {
        within_reach(&products, &displacement, m - 1, highest_power)?;
        products.push(motion, displacement[m - 1].clone());
        products.advance(m - 1);
        accelerations.push(displacement[m - 1].derivative().derivative());
        let linear_series = constant_series(linear.clone());
        let mut terms = vec![(1, &linear_series, &displacement[m - 1])];
        let coefficients = force.terms.iter().map(|term| constant_series(term.coefficient.clone()));
        let coefficients: Vec<_> = coefficients.collect();
        let known = powers.iter().map(|&power| products.order(power, m - 1));
        terms.extend(
            coefficients
                .iter()
                .zip(known)
                .filter_map(|(c, power)| Some((1, c, power?))),
        );
        let mut right_side = sum_of_products(&POLYNOMIALS, &terms);
        if m == 1 {
            // w_0^2 A = c_1
            let squared = right_side
                .cosine(1)
                .constant_term()
                .times_monomial(&Monomial::power_of(amplitude, -1));
            let first = linear_frequency(&squared, solution);
            // From here on omega0^2 = w_0^2 - (the rest of w_0^2), so that what cancels does so term by term.
            linear = squared.clone();
            linear.negate();
            linear.accumulate(&force.linear);
            linear.accumulate(&first.product(&first));
            inverse = first.inverse().map_or_else(
                || FourierSeries::zero(POLYNOMIALS),
                |(unit, integer)| {
                    FourierSeries::constant(POLYNOMIALS, unit).divided_by(i64::try_from(&integer).unwrap_or(1))
                },
            );
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
            squares.push(0, constant_series(first.clone()));
            frequency.push(constant_series(first));
        } else {
            right_side = right_side.sum(&squares.inertia_without_last(&accelerations, m - 1));
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
                &next.constant_term(),
            ));
            squares.push(m - 1, next.clone());
            frequency.push(next);
        }
        if m == order {
            break;
        }
        // What is left of the first harmonic has been removed by w_(m-1).
        let (particular, _) = right_side.solve_oscillator();
        let scaled = particular.product(&hbar).product(&inverse).product(&inverse);
        let mut next = scaled.difference(&scaled.at_zero().product(&FourierSeries::cos(POLYNOMIALS, 1)));
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
fn secular_lines(name: Symbol, residual: &FourierSeries<Polynomials>, unknown: Expr, value: &Polynomial) -> Vec<Line> {
    let secular = residual.cosine(1).constant_term();
    vec![
        Line::equation(name, residual.clone()),
        Line::equation(&secular, Expr::zero()).because(format!("no cos(theta) in {name}")),
        Line::equation(unknown, value),
    ]
}

/// An error where order `k` of the powers of `u` would take far more algebra than anyone waits for.
///
/// Counted are the products of terms with which each power follows from the one before; of the powers that the force does not
/// need the size is that of the others.
fn within_reach(
    products: &Convolutions<Polynomials>,
    displacement: &[FourierSeries<Polynomials>],
    k: usize,
    highest: u32,
) -> Result<(), SecularError> {
    if highest <= HIGH_POWER {
        return Ok(());
    }
    let size = |series: &FourierSeries<Polynomials>| series.numerators().map(|c| c.terms().len()).sum::<usize>();
    let of_order = |i: usize| size(&displacement[i]) * products.orders(k - i).map(size).sum::<usize>();
    let count = (1..=k).map(of_order).sum::<usize>() * highest as usize / products.count();
    match count > MOST_PRODUCTS {
        true => Err(SecularError::TooManyHarmonics {
            degree: highest,
            harmonics: displacement[k].highest_harmonic() + highest as usize - 1,
        }),
        false => Ok(()),
    }
}

/// `w^2` order by order: each order but the last of `w`, which is not known yet.
struct Squares {
    products: Convolutions<Polynomials>,
    frequency: convolution::Node,
    square: convolution::Node,
}

impl Squares {
    fn new(highest: usize) -> Self {
        let mut products = Convolutions::new(POLYNOMIALS);
        let frequency = products.leaf();
        let square = products.product(frequency, frequency);
        products.require(square, highest);
        Self {
            products,
            frequency,
            square,
        }
    }

    /// Supplies the next `w_k`.
    fn push(&mut self, k: usize, series: FourierSeries<Polynomials>) {
        self.products.push(self.frequency, series);
        self.products.advance(k);
    }

    /// The coefficient of `q^k` in `w^2 u''` without the term of the unknown `w_k`; `accelerations` are those of `u`.
    fn inertia_without_last(
        &self,
        accelerations: &[FourierSeries<Polynomials>],
        k: usize,
    ) -> FourierSeries<Polynomials> {
        let w = |i: usize| self.products.order(self.frequency, i);
        let known: Vec<_> = (1..k).filter_map(|i| Some((1, w(i)?, w(k - i)?))).collect();
        let last = sum_of_products(&POLYNOMIALS, &known);
        let mut terms = vec![(1, &last, &accelerations[0])];
        terms.extend((0..k).filter_map(|n| Some((1, self.products.order(self.square, n)?, &accelerations[k - n]))));
        sum_of_products(&POLYNOMIALS, &terms)
    }
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

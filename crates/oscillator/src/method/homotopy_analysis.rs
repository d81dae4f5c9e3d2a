//! Homotopy analysis: a homotopy with a convergence-control parameter, in which the frequency is
//! expanded as well.
//!
//! Reference: S. Liao, *Beyond Perturbation: Introduction to the Homotopy Analysis Method*, Chapman
//! & Hall/CRC 2003, chapter 7 (free oscillations); S. Liao, Int. J. Non-Linear Mech. 34 (1999)
//! 759-778.
//!
//! ```text
//! N[u, w] = w^2 u'' + f(u),   L[u] = w_0^2 (u'' + u),   derivatives in theta,   u_0 = A cos theta
//! L[u_m - chi_m u_(m-1)] = hbar R_m,   R_m = coefficient of q^(m-1) in N[sum q^k u_k, sum q^k w_k],   chi_1 = 0, else 1
//! no secular term in R_m fixes w_(m-1);   u_m(0) = 0
//! omega = w_0 + w_1 + ...,   E(hbar) = (1/(2 pi)) int_0^(2 pi) N[u, omega]^2 dtheta smallest
//! ```
//!
//! With hbar = -1 this is the homotopy in which omega itself, not omega0^2, is expanded. Order 1 is
//! `w_0` alone.
//!
//! Cost: that of the products of the force in `m` orders; at an amplitude, that of the search for hbar
//! (`convergence_control`).
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::HomotopyAnalysis), ..Options::default() };
//! let solution = solve(&duffing, &options)?;
//! assert_eq!(solution.law.frequency().unwrap().to_string(), "w0 + 3*eps^2*hbar*A^4/(256*w0^3)");
//! assert_eq!(solution.definitions[0].meaning.to_string(), "sqrt(4 + 3*eps*A^2)/2");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use num_traits::{One, ToPrimitive};

use super::expansion::{over_integers, to_fractions};
use super::one_term::{conservative_force, unsolved};
use super::secular::SecularError;
use super::{Options, Reason, Refusal};
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::exact::polynomial::Monomial;
use crate::exact::{Integers, Polynomial, Polynomials, Rational};
use crate::expr::{Expr, Node};
use crate::oscillator::{Oscillator, PerturbedForce, SmallParameter};
use crate::series::FourierSeries;
use crate::series::convolution::{self, Convolutions};
use crate::series::fourier::{linear_combination, sum_of_products};
use crate::solution::note::Truncation;
use crate::solution::{Definition, Law, Method, Note, Solution};
use crate::symbol::{Symbol, fresh, fresh_stem};

const METHOD: Method = Method::HomotopyAnalysis;

/// The highest order: coefficients are polynomials in hbar, A, w0 and the parameters.
const HIGHEST: u32 = 20;

/// The most terms of one coefficient before the derivation is given up.
const MOST_TERMS: usize = 20_000;

/// Above this power of the force, coefficients have hundreds of digits, and the number of their
/// products is limited.
const HIGH_POWER: u32 = 30;
const MOST_PRODUCTS: usize = 1_000_000;

/// The name of the convergence-control parameter, with underscores behind it where the equation
/// uses the name.
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
        return Err(Reason::HighestOrder(HIGHEST).to(METHOD));
    }
    let polynomial = oscillator.polynomial_degree()?;
    let degree = match polynomial {
        Some(degree) if options.taylor.is_none() => degree,
        _ => options.taylor.unwrap_or(2 * order + 1),
    };
    let force = oscillator
        .expand_with_any_stiffness(SmallParameter::Amplitude, degree.saturating_sub(1))?;
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
    let sum = |series: &[FourierSeries<Symbols>]| {
        let terms: Vec<_> = series.iter().map(|term| (1, term)).collect();
        to_fractions(&linear_combination(&SYMBOLS, &terms))
    };
    solution.law = Law::Frequency(sum(&series.frequency).constant_term());
    solution.displacement = sum(&series.displacement);
    let embedding = fresh("q", &solution.names());
    solution.validity.push(Note::Cut(Truncation::Corrections { order, embedding }));
    if polynomial.is_none() {
        solution.validity.push(Note::TaylorPolynomial { degree });
    }
    if options.hbar.is_none() && order > 1 {
        solution.validity.push(Note::ConvergenceControl(symbol));
    }
    Ok(solution)
}

/// The ring of the derivation: polynomials with whole coefficients, over the one denominator of a
/// series, so that sums of fractions are sums of integers.
type Symbols = Polynomials<Integers>;
const SYMBOLS: Symbols = Polynomials(Integers);

struct HomotopySeries {
    frequency: Vec<FourierSeries<Symbols>>,
    displacement: Vec<FourierSeries<Symbols>>,
}

fn expand(
    force: &PerturbedForce,
    order: usize,
    hbar: Polynomial,
    solution: &mut Solution,
) -> Result<HomotopySeries, Refusal> {
    let mut expansion = HomotopyExpansion::new(force, order, hbar, solution);
    for m in 1..=order {
        let residual = expansion.residual(m)?;
        let residual = match m {
            1 => expansion.first_frequency(residual)?,
            _ => expansion.correction(m, residual),
        };
        if m < order {
            expansion.next_displacement(m, &residual)?;
        }
    }
    expansion.solution.derivation = expansion.lines;
    Ok(expansion.series)
}

/// The series as far as they are known, and the quantities from which their next order follows.
struct HomotopyExpansion<'a> {
    force: &'a PerturbedForce,
    solution: &'a mut Solution,
    series: HomotopySeries,
    /// The second derivatives of the displacement.
    accelerations: Vec<FourierSeries<Symbols>>,
    /// The powers of the displacement that stand in the force.
    products: Convolutions<Symbols>,
    motion: convolution::SeriesNode,
    powers: Vec<convolution::SeriesNode>,
    squares: Squares,
    hbar: FourierSeries<Symbols>,
    /// `1/w_0`.
    inverse: FourierSeries<Symbols>,
    /// The linear stiffness, with `w_0` in place of what cancels.
    linear: Polynomial,
    lines: Vec<DerivationLine>,
    /// The letters of displacements, frequencies and residuals.
    letters: [String; 3],
    /// The name of `w_0`.
    first_frequency_name: Symbol,
}

fn numbered(letter: &str, number: usize) -> Symbol {
    Symbol::new(&format!("{letter}{number}"))
}

impl<'a> HomotopyExpansion<'a> {
    fn new(
        force: &'a PerturbedForce,
        order: usize,
        hbar: Polynomial,
        solution: &'a mut Solution,
    ) -> Self {
        let amplitude = over_integers(&Polynomial::symbol(Symbol::new("A")));
        let start = amplitude.product(&FourierSeries::cos(SYMBOLS, 1));
        let mut products = Convolutions::new(SYMBOLS);
        let motion = products.leaf();
        let terms = force.terms.iter();
        let powers: Vec<convolution::SeriesNode> =
            terms.map(|term| products.power(motion, term.position)).collect();
        powers.iter().for_each(|&power| products.require(power, order - 1));
        let names = solution.names();
        let letters = ["u", "w", "R"].map(|letter| fresh_stem(letter, &names));
        Self {
            force,
            products,
            motion,
            powers,
            squares: Squares::new(order - 1),
            accelerations: vec![],
            hbar: over_integers(&hbar),
            inverse: FourierSeries::zero(SYMBOLS),
            linear: force.linear.clone(),
            lines: vec![DerivationLine::equation(numbered(&letters[0], 0), to_fractions(&start))],
            series: HomotopySeries { frequency: vec![], displacement: vec![start] },
            first_frequency_name: numbered(&letters[1], 0),
            letters,
            solution,
        }
    }

    /// `R_m` without the frequency that it fixes.
    fn residual(&mut self, m: usize) -> Result<FourierSeries<Symbols>, Refusal> {
        let force = self.force;
        let highest_power = force.terms.iter().map(|term| term.position).max().unwrap_or(1);
        let displacement = &self.series.displacement;
        within_reach(&self.products, displacement, m - 1, highest_power)?;
        self.products.push(self.motion, displacement[m - 1].clone());
        self.products.advance(m - 1);
        self.accelerations.push(displacement[m - 1].derivative().derivative());
        let linear = over_integers(&self.linear);
        let mut terms = vec![(1, &linear, &displacement[m - 1])];
        let coefficients: Vec<_> =
            force.terms.iter().map(|term| over_integers(&term.coefficient)).collect();
        let known = self.powers.iter().map(|&power| self.products.order(power, m - 1));
        let powers = coefficients.iter().zip(known);
        terms.extend(powers.filter_map(|(c, power)| Some((1, c, power?))));
        let residual = sum_of_products(&SYMBOLS, &terms);
        Ok(match m {
            1 => residual,
            _ => residual.sum(&self.squares.inertia_without_last(&self.accelerations, m - 1)),
        })
    }

    /// `w_0^2 A = c_1`, and `R_1` with it.
    fn first_frequency(
        &mut self,
        residual: FourierSeries<Symbols>,
    ) -> Result<FourierSeries<Symbols>, Refusal> {
        let by_amplitude = Monomial::power_of(Symbol::new("A"), -1);
        let squared =
            to_fractions(&residual.cosine(1)).constant_term().times_monomial(&by_amplitude);
        let first = linear_frequency(&squared, self.solution);
        // From here on omega0^2 = w_0^2 - (the rest of w_0^2), so that what cancels does so term by
        // term.
        self.linear = squared.clone();
        self.linear.negate();
        self.linear.accumulate(&self.force.linear);
        self.linear.accumulate(&first.product(&first));
        self.inverse = first.inverse().map_or_else(
            || FourierSeries::zero(SYMBOLS),
            |(unit, integer)| over_integers(&unit).divided_by(integer.to_i64().unwrap_or(1)),
        );
        let defined =
            |name: &Symbol| self.solution.definitions.iter().any(|entry| entry.symbol == *name);
        let name = first.single_term().filter(|(_, number)| number.is_one());
        let name = name.and_then(|(monomial, _)| Some(monomial.factors().first()?.0));
        if let Some(name) = name.filter(defined) {
            self.first_frequency_name = name;
        }
        let name = self.first_frequency_name;
        let start = self.series.displacement[0].times(-1);
        let inertia = |square: &Polynomial| start.product(&over_integers(square));
        let unknown = inertia(&Polynomial::term(Monomial::power_of(name, 2), Rational::one()));
        self.lines.extend(secular_lines(
            numbered(&self.letters[2], 1),
            &residual.sum(&unknown),
            Expr::from(name).integer_power(2)?,
            &squared,
        ));
        let residual = residual.sum(&inertia(&first.product(&first)));
        self.push_frequency(over_integers(&first));
        Ok(residual)
    }

    /// `-2 w_0 w_(m-1) A + r = 0`, where `r` is the first harmonic of `R_m`.
    fn correction(&mut self, m: usize, residual: FourierSeries<Symbols>) -> FourierSeries<Symbols> {
        let by_amplitude =
            Polynomial::term(Monomial::power_of(Symbol::new("A"), -1), Rational::one());
        let by_amplitude = over_integers(&by_amplitude);
        let first_harmonic = residual.cosine(1).product(&self.inverse);
        let next = first_harmonic.product(&by_amplitude).divided_by(2);
        let name = numbered(&self.letters[1], m - 1);
        let unknown = self.series.frequency[0]
            .product(&self.series.displacement[0])
            .product(&over_integers(&Polynomial::symbol(name)))
            .times(-2);
        self.lines.extend(secular_lines(
            numbered(&self.letters[2], m),
            &residual.sum(&unknown),
            name.into(),
            &to_fractions(&next).constant_term(),
        ));
        self.push_frequency(next);
        residual
    }

    fn push_frequency(&mut self, next: FourierSeries<Symbols>) {
        self.squares.push(self.series.frequency.len(), next.clone());
        self.series.frequency.push(next);
    }

    /// `u_m''+ u_m = u_(m-1)'' + u_(m-1) + hbar R_m/w_0^2`, `u_m(0) = u_m'(0) = 0`.
    fn next_displacement(
        &mut self,
        m: usize,
        residual: &FourierSeries<Symbols>,
    ) -> Result<(), Refusal> {
        // The remaining first harmonic has been removed by w_(m-1).
        let (particular, _) = residual.solve_oscillator();
        let scaled = particular.product(&self.hbar).product(&self.inverse).product(&self.inverse);
        let mut next =
            scaled.difference(&scaled.at_zero().product(&FourierSeries::cos(SYMBOLS, 1)));
        if m > 1 {
            next = next.sum(&self.series.displacement[m - 1]);
        }
        let longest = next.numerators().map(|numerator| numerator.terms().len()).max();
        if longest.is_some_and(|longest| longest > MOST_TERMS) {
            return Err(Reason::TooLong(MOST_TERMS).into());
        }
        let [u, _, r] = &self.letters;
        let (name, before, residual) = (numbered(u, m), numbered(u, m - 1), numbered(r, m));
        let (control, first_frequency) =
            (convergence_control(self.solution), self.first_frequency_name);
        let driven = to_fractions(&next.sum(&next.derivative().derivative()));
        let left = DerivationFormula::oscillator(name, Expr::one());
        let change = format!("{control}*{residual}/{first_frequency}^2");
        self.lines.push(DerivationLine::equal([left, driven.into()]).because(match m {
            1 => format!("{name}'' + {name} = {change}"),
            _ => format!("{name}'' + {name} = {before}'' + {before} + {change}"),
        }));
        let start = |derivatives| DerivationFormula::AtZero { of: name, derivatives };
        self.lines.push(DerivationLine::equal([start(0), start(1), Expr::zero().into()]));
        self.lines.push(DerivationLine::equation(name, to_fractions(&next)));
        self.series.displacement.push(next);
        Ok(())
    }
}

/// `R_m` with the unknown frequency in it, and the condition that fixes that.
fn secular_lines(
    name: Symbol,
    residual: &FourierSeries<Symbols>,
    unknown: Expr,
    value: &Polynomial,
) -> Vec<DerivationLine> {
    let residual = to_fractions(residual);
    let secular = residual.cosine(1).constant_term();
    vec![
        DerivationLine::equation(name, residual.clone()),
        DerivationLine::equation(&secular, Expr::zero()).because(format!("no cos(θ) in {name}")),
        DerivationLine::equation(unknown, value),
    ]
}

/// An error if order `k` of the powers of `u` would take far too much algebra.
///
/// The count is that of the products of terms with which each power follows from the one before;
/// powers that are not stored are taken to be as long as the others.
fn within_reach(
    products: &Convolutions<Symbols>,
    displacement: &[FourierSeries<Symbols>],
    k: usize,
    highest: u32,
) -> Result<(), SecularError> {
    if highest <= HIGH_POWER {
        return Ok(());
    }
    let size = |series: &FourierSeries<Symbols>| {
        series.numerators().map(|c| c.terms().len()).sum::<usize>()
    };
    let of_order =
        |i: usize| size(&displacement[i]) * products.orders(k - i).map(size).sum::<usize>();
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
    products: Convolutions<Symbols>,
    frequency: convolution::SeriesNode,
    square: convolution::SeriesNode,
}

impl Squares {
    fn new(highest: usize) -> Self {
        let mut products = Convolutions::new(SYMBOLS);
        let frequency = products.leaf();
        let square = products.product(frequency, frequency);
        products.require(square, highest);
        Self { products, frequency, square }
    }

    /// Supplies the next `w_k`.
    fn push(&mut self, k: usize, series: FourierSeries<Symbols>) {
        self.products.push(self.frequency, series);
        self.products.advance(k);
    }

    /// The coefficient of `q^k` in `w^2 u''` without the term of the unknown `w_k`; `accelerations`
    /// are those of `u`.
    fn inertia_without_last(
        &self,
        accelerations: &[FourierSeries<Symbols>],
        k: usize,
    ) -> FourierSeries<Symbols> {
        let w = |i: usize| self.products.order(self.frequency, i);
        let known: Vec<_> = (1..k).filter_map(|i| Some((1, w(i)?, w(k - i)?))).collect();
        let last = sum_of_products(&SYMBOLS, &known);
        let mut terms = vec![(1, &last, &accelerations[0])];
        terms.extend((0..k).filter_map(|n| {
            Some((1, self.products.order(self.square, n)?, &accelerations[k - n]))
        }));
        sum_of_products(&SYMBOLS, &terms)
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

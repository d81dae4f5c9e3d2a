//! A derived formula, and its verification if there is one.

use std::borrow::Cow;

use num_traits::{One, Signed, Zero};

use super::{Block, Document};
use crate::decimal::decimal;
use crate::exact::rational::{from_f64, to_f64};
use crate::exact::{Monomial, Polynomial, Rational};
use crate::expr::Expr;
use crate::method::homotopy_analysis::convergence_control;
use crate::solution::law::DisplayedLaw;
use crate::solution::modulation::Release;
use crate::solution::{LeadingCycle, LimitCycle, Modulation, Solution, Sum, constant_in_words};
use crate::symbol::{Symbol, fresh};
use crate::verify::Verification;

/// The document of a solution: equation, title, law, limit cycle, motion with definitions,
/// validity, verdict.
///
/// ```
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// let document = lindstedt::report::solution(&solution, None);
/// assert!(lindstedt::export::latex::document(&document).contains(r"\omega^{2}"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solution<'a>(
    solution: &'a Solution,
    verification: Option<&'a Verification>,
) -> Document<'a> {
    if let Some(response) = &solution.response {
        return super::driven::driven(solution, response, verification);
    }
    let title = Block::Title {
        words: solution.title(),
        amplitude: solution.amplitude.in_words(solution.coordinate()),
    };
    let shown = solution.law.display_forms();
    let laws = match solution.slow() {
        Some(slow) => slow_equations(solution, slow),
        None => shown.into_iter().flat_map(|law| law_blocks(solution, law)).collect(),
    };
    let mut sections = vec![vec![Block::Question(&solution.equation)], vec![title], laws];
    // If the motion is left out, so is its amplitude.
    let cycle = solution.limit_cycle.as_ref();
    if let Some(cycle) = cycle.filter(|_| !solution.displacement.is_zero()) {
        let amplitude = Block::CycleAmplitude {
            symbol: solution.amplitude.symbol(),
            amplitude: solution.ordered(&cycle.amplitude),
        };
        let others = other_cycles(cycle, solution).into_iter().map(Block::Remark);
        sections.push(std::iter::once(amplitude).chain(others).collect());
    }
    sections.push(std::iter::once(Block::Motion(solution)).chain(definitions(solution)).collect());
    if let Some(slow) = solution.slow() {
        sections.extend(slow_motion(slow));
    } else if solution.limit_cycle.is_some() {
        let slow = solution.modulation.as_ref().filter(|slow| slow.release.is_some());
        sections.extend(slow.into_iter().flat_map(|slow| approach(solution, slow)));
    }
    let notes = solution.validity.iter().map(ToString::to_string);
    let notes = notes.chain(solution.convergence.iter().map(ToString::to_string));
    let notes = notes.map(Block::Note);
    let heading = Block::Heading("Validity".to_owned());
    sections.push(std::iter::once(heading).chain(notes).collect());
    sections.extend(verification.map(|verification| vec![judged(solution, verification)]));
    Document { sections }
}

/// A law as blocks.
pub(super) fn law_blocks<'a>(solution: &'a Solution, law: DisplayedLaw<'a>) -> Vec<Block<'a>> {
    let omega = Expr::symbol("omega");
    let explicit = |left: Expr, right| Block::Law { left, right: solution.ordered(right) };
    match law {
        DisplayedLaw::Squared(squared) => vec![explicit(&omega * &omega, squared)],
        DisplayedLaw::Frequency(frequency) => vec![explicit(omega, frequency)],
        DisplayedLaw::Relation(relation) => {
            vec![Block::Law { left: Expr::zero(), right: solution.by_falling_frequency(relation) }]
        }
        DisplayedLaw::Closed(form) => {
            let left = if form.squared { &omega * &omega } else { omega };
            in_decimals(solution, &form.value, &left)
                .unwrap_or_else(|| vec![Block::Equality { left, right: &form.value }])
        }
        DisplayedLaw::Quadrature(lines) => {
            lines.iter().map(|line| Block::Line(Cow::Borrowed(line))).collect()
        }
        DisplayedLaw::System(system) => {
            let equations = system.equations.iter();
            let equations = equations.map(|right| Block::Equality { left: Expr::zero(), right });
            let names: Vec<&str> = system.unknowns.iter().map(|name| name.written()).collect();
            let unknowns = Block::Detail(format!("for {}:", names.join(", ")));
            std::iter::once(unknowns).chain(equations).collect()
        }
    }
}

/// Largest number of binary digits of a number that is printed exactly: some six hundred decimal
/// ones.
const LONGEST: u64 = 2000;

/// Digits of the coefficients of a closed form that are rounded themselves.
const ROUNDED_DIGITS: usize = 15;

/// A quotient of polynomials whose coefficients are rounded, or too long to be read, in decimals;
/// `None` for everything else.
fn in_decimals<'a>(solution: &Solution, value: &Expr, left: &Expr) -> Option<Vec<Block<'a>>> {
    solution.degrees?;
    let fraction = value.fraction();
    let polynomial =
        |factors: Vec<Expr>| Expr::product(factors).to_polynomial(&mut |_| None).ok().flatten();
    let above = polynomial(fraction.numerator)?;
    let below = polynomial(fraction.denominator)?;
    let longest = longest([&above, &below])?;
    if longest < LONGEST && !solution.numerical {
        return None;
    }
    let digits = if solution.numerical { ROUNDED_DIGITS } else { 6 };
    let rounded = |name, polynomial: &Polynomial| rounded(solution, name, polynomial, digits);
    let remark = (!solution.numerical).then(|| rounded_to(longest));
    let first = below.coefficient(&Monomial::one());
    let sign = if fraction.negative { -Rational::one() } else { Rational::one() };
    // A double has all digits that are shown, and is the same without lowest terms, which would take
    // longer here than everything else.
    let quotient = |number: &Rational, factor: &Rational| {
        let [above, below] = [number.numer() * first.denom(), number.denom() * first.numer()];
        let sign = if below.is_negative() { -factor } else { factor.clone() };
        let rounded = to_f64(&Rational::new_raw(above, below.abs()));
        let rounded = Some(rounded).filter(|value| value.is_normal()).and_then(from_f64);
        rounded.map_or_else(|| number * factor / &first, |value| value * sign)
    };
    let over = |polynomial: &Polynomial, factor: &Rational| {
        polynomial.map(|number| quotient(number, factor))
    };
    let letters = ["P", "Q"].map(|letter| fresh(letter, &solution.names()));
    let law = Monomial::power_of(letters[0], 1).product(&Monomial::power_of(letters[1], -1));
    let law = Polynomial::term(law, Rational::one());
    (!first.is_zero()).then(|| {
        let law = Block::Law {
            left: left.clone(),
            right: Sum::new(&law, false, |monomial| solution.order_of(monomial)),
        };
        let letters = [
            rounded(letters[0], &over(&above, &sign)),
            rounded(letters[1], &over(&below, &Rational::one())),
        ];
        std::iter::once(law).chain(letters).chain(remark).collect()
    })
}

/// The binary digits of the longest numerator.
fn longest<'a>(polynomials: impl IntoIterator<Item = &'a Polynomial>) -> Option<u64> {
    let numbers = polynomials.into_iter().flat_map(Polynomial::terms);
    numbers.map(|(_, number)| number.numer().bits()).max()
}

/// A polynomial with long coefficients.
fn rounded<'a>(
    solution: &Solution,
    name: Symbol,
    polynomial: &Polynomial,
    digits: usize,
) -> Block<'a> {
    let sum = Sum::new(polynomial, true, |monomial| solution.order_of(monomial));
    Block::Law { left: Expr::from(name), right: sum.with_digits(digits) }
}

fn rounded_to<'a>(longest: u64) -> Block<'a> {
    Block::Remark(format!(
        "in decimals of six digits here, for they have {} digits; as JSON they are exact",
        (longest as f64 * std::f64::consts::LOG10_2).ceil()
    ))
}

/// The definitions; polynomials with coefficients that are too long to be read are in decimals.
fn definitions(solution: &Solution) -> Vec<Block<'_>> {
    let polynomial = |meaning: &Expr| meaning.to_polynomial(&mut |_| None).ok().flatten();
    let mut blocks = vec![];
    let mut digits = None;
    for definition in &solution.definitions {
        let polynomial = solution.degrees.and_then(|_| polynomial(&definition.meaning));
        let long = polynomial.and_then(|own| Some((longest([&own])?, own)));
        blocks.push(match long.filter(|(bits, _)| *bits >= LONGEST) {
            Some((bits, polynomial)) => {
                digits = digits.max(Some(bits));
                rounded(solution, definition.symbol, &polynomial, 6)
            }
            None => Block::Definition(definition),
        });
    }
    blocks.extend(digits.map(rounded_to));
    blocks
}

/// The slow equations: `a' = ...`, `psi' = ...`.
fn slow_equations<'a>(solution: &'a Solution, slow: &'a Modulation) -> Vec<Block<'a>> {
    let rates = [(slow.amplitude, &slow.amplitude_rate), (slow.phase, &slow.phase_rate)];
    let polynomials = rates.map(|(_, right)| right.to_polynomial(&mut |_| None).ok().flatten());
    // Both rates are shown in the same form.
    let both = polynomials.iter().all(Option::is_some);
    let equation = |((name, right), polynomial): ((Symbol, &'a Expr), Option<Polynomial>)| {
        let left = Expr::from(name.derivative());
        match polynomial.filter(|_| both) {
            Some(polynomial) => Block::Law { left, right: solution.ordered(&polynomial) },
            None => Block::Equality { left, right },
        }
    };
    rates.into_iter().zip(polynomials).map(equation).collect()
}

/// The steady amplitudes, and the motion from its start in closed form.
fn slow_motion(slow: &Modulation) -> Vec<Vec<Block<'_>>> {
    let mut sections = vec![];
    if !slow.steady.is_empty() {
        let line = |cycle: &LeadingCycle| {
            let amplitude = constant_in_words(&cycle.amplitude);
            Block::Remark(format!("{} = {amplitude} stays: {}", slow.amplitude, cycle.stability()))
        };
        sections.push(slow.steady.iter().map(line).collect());
    }
    sections.extend(from_start(slow));
    sections
}

/// The motion towards a limit cycle or away from it: the slow equations, and the motion from its
/// start in closed form.
fn approach<'a>(solution: &'a Solution, slow: &'a Modulation) -> Vec<Vec<Block<'a>>> {
    let mut blocks = vec![Block::Heading("Off the cycle".to_owned())];
    blocks.extend(slow_equations(solution, slow));
    std::iter::once(blocks).chain(from_start(slow)).collect()
}

/// The motion from its start in closed form; `None` if there is none.
fn from_start(slow: &Modulation) -> Option<Vec<Block<'_>>> {
    let transient = slow.transient.as_ref()?;
    let start = transient.start;
    let phase = transient
        .phase
        .as_ref()
        .map(|phase| Block::Equality { left: Expr::from(slow.phase), right: phase });
    let ends = transient.ends.as_ref().map(|ends| {
        let what = match slow.amplitude_rate.has_leading_minus() {
            true => "the amplitude is zero",
            false => "the amplitude grows beyond every bound",
        };
        Block::Remark(format!("until t = {ends}, where {what}"))
    });
    let heading = match slow.release.as_ref().is_some_and(Release::is_at_start) {
        true => format!("Released at rest from {start} > 0"),
        false => format!("From {}(0) = {start}", slow.amplitude),
    };
    let amplitude =
        Block::Equality { left: Expr::from(slow.amplitude), right: &transient.amplitude };
    let blocks = [Block::Heading(heading), amplitude].into_iter().chain(phase).chain(ends);
    Some(blocks.collect())
}

/// The verdict, with the relevant numbers.
fn judged<'a>(solution: &Solution, verification: &'a Verification) -> Block<'a> {
    /// Difference below which two errors count as equal.
    const SAME: f64 = 1e-9;
    let differs = |other: &f64| {
        let error = verification.relative_error;
        error.is_none_or(|error| (other - error).abs() > SAME)
    };
    Block::Judged {
        verification,
        series_of_omega: verification.error_of_omega.filter(differs),
        hbar: convergence_control(solution),
    }
}

/// The limit cycles of an equation that has several of them, to leading order.
fn other_cycles(cycle: &LimitCycle, solution: &Solution) -> Vec<String> {
    if cycle.cycles.len() < 2 {
        return vec![];
    }
    let symbol = solution.amplitude.symbol();
    let small: Vec<&str> = solution.small_parameters().map(Symbol::written).collect();
    let head =
        format!("cycle {} of {}; for {} -> 0:", cycle.number, cycle.cycles.len(), small.join(", "));
    let line = |(k, each): (usize, &LeadingCycle)| {
        let own = if k + 1 == cycle.number { "*" } else { " " };
        let amplitude = &each.amplitude;
        let value = match amplitude.as_number() {
            Some(_) => String::new(),
            None => {
                let value = amplitude.evaluate(&std::collections::BTreeMap::new());
                value.map_or_else(|_| String::new(), |value| format!(" = {}", decimal(value)))
            }
        };
        let exact = constant_in_words(amplitude);
        format!("{own} {}  {symbol} = {exact}{value}, {}", k + 1, each.stability())
    };
    std::iter::once(head).chain(cycle.cycles.iter().enumerate().map(line)).collect()
}

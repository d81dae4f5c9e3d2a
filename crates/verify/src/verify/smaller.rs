//! The problem with all small quantities halved repeatedly, by which the order of an error is
//! measured.
//!
//! ```text
//! small letters            their values halved, among them those of a drive that counts as small, and the detuning
//! small terms in numbers   the equation seen from the equilibrium, all but its linear force halved
//! small amplitude          x = x_eq + s y, s^2 halved:   y'' + f(x_eq + s y, s y')/s = 0, in which the amplitude stays as it is;
//!                          damping, detuning and a small drive by the power of s that the nonlinear terms have, s^4 for x^5 alone
//! ```
//!
//! If the small quantities are numbers, the answer to the smaller problem is derived again. A drive
//! far from resonance is not small and stays; a drive gets the frequency with half of the detuning.

use std::collections::BTreeMap;

use num_traits::ToPrimitive as _;

use crate::equilibrium::centred;
use crate::exact::rational::{from_f64, ratio};
use crate::expr::{Expr, ExprError, Node};
use crate::method::multiple_scales::scaling::order_of_balance;
use crate::method::{Options, solve};
use crate::oscillator::Oscillator;
use crate::series::taylor::taylor;
use crate::solution::modulation::Resonance;
use crate::solution::{AmplitudeConvention, Note, Solution};
use crate::symbol::Symbol;

/// A problem and its answer.
pub(super) struct Smaller {
    pub(super) oscillator: Oscillator,
    pub(super) solution: Solution,
    pub(super) numbers: BTreeMap<Symbol, f64>,
}

/// The problem with all small quantities halved this many times; `None` if that is not possible.
pub(super) fn smaller(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    halvings: i32,
) -> Option<Smaller> {
    let factor = 0.5_f64.powi(halvings);
    by_letters(oscillator, solution, numbers, factor)
        .or_else(|| by_numbers(oscillator, solution, numbers, factor))
}

/// Whether the amplitude is the small quantity.
pub(super) fn is_small_in_amplitude(solution: &Solution) -> bool {
    solution.small_parameter == solution.amplitude.symbol()
}

/// The power of the amplitude as which damping, detuning and a small drive count in an expansion in
/// that.
fn power_of_balance(oscillator: &Oscillator, order: u32) -> i32 {
    let order = || {
        let centred = centred(oscillator, None).ok()?.oscillator;
        let mut free = centred.clone();
        free.force = (&centred.force - &centred.parts().ok()?.forcing).expand().ok()?;
        i32::try_from(order_of_balance(&free, order)).ok()
    };
    order().unwrap_or(2)
}

fn resonance(solution: &Solution) -> Option<&Resonance> {
    solution.modulation.as_ref()?.resonance.as_ref()
}

/// The quantities, except the detuning, that count as small in addition to the small parameters of
/// a driven motion.
fn small_drives<'a>(solution: &'a Solution, resonance: &Resonance) -> Vec<&'a Expr> {
    let detuning = Expr::from(resonance.detuning.symbol);
    let notes = solution.validity.iter();
    let small = notes.filter_map(|note| match note {
        Note::Driven { small, .. } => Some(small),
        _ => None,
    });
    small.flatten().filter(|small| **small != detuning).collect()
}

/// The driving frequency with this fraction of its detuning.
fn retuned(
    solution: &Solution,
    resonance: &Resonance,
    numbers: &BTreeMap<Symbol, f64>,
    factor: f64,
) -> Option<[f64; 2]> {
    let mut known = numbers.clone();
    known.extend(solution.defined_values(&|name| numbers.get(&name).copied()).ok()?);
    let driving = resonance.driving_frequency.evaluate(&known).ok()?;
    let detuning = resonance.detuning.meaning.evaluate(&known).ok()?;
    let less = driving - (1.0 - factor) * detuning / f64::from(resonance.times_driving);
    Some([driving, less])
}

/// The smaller problem if the small quantities are parameters: their values are halved.
fn by_letters(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    factor: f64,
) -> Option<Smaller> {
    let mut small: Vec<Symbol> = solution.small_parameters().collect();
    let mut smaller = numbers.clone();
    if let Some(resonance) = resonance(solution) {
        for drive in small_drives(solution, resonance) {
            let letters =
                drive.symbols().into_iter().filter(|name| oscillator.parameters.contains(name));
            let letters: Vec<Symbol> = letters.collect();
            let [letter] = letters.as_slice() else {
                return None;
            };
            // A drive that is a multiple of the parameter is halved with it.
            let zero = drive.substitute(*letter, &Expr::zero()).ok()?;
            let slope = drive.differentiate(*letter).ok()?;
            if !zero.is_zero() || slope.contains(*letter) {
                return None;
            }
            small.push(*letter);
        }
        let [_, less] = retuned(solution, resonance, numbers, factor)?;
        *smaller.get_mut(&resonance.driving_frequency.as_symbol()?)? = less;
    }
    small.sort();
    small.dedup();
    for name in small {
        if solution.equilibrium.contains(name) {
            return None;
        }
        *smaller.get_mut(&name)? *= factor;
    }
    Some(Smaller { oscillator: oscillator.clone(), solution: solution.clone(), numbers: smaller })
}

/// The smaller problem if the small quantities are numbers in the equation, about the equilibrium.
fn by_numbers(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    factor: f64,
) -> Option<Smaller> {
    let in_amplitude = is_small_in_amplitude(solution);
    // The drive that balances the nonlinear terms scales with a power of the amplitude, and the
    // square of the amplitude is halved.
    let power = if in_amplitude { power_of_balance(oscillator, solution.order) } else { 2 };
    let factor_of_balance = factor.powf(f64::from(power) / 2.0);
    let number = |value: f64| from_f64(value).map(Expr::number);
    let (factor_number, root) = (number(factor)?, number(factor.sqrt())?);
    let known: Option<BTreeMap<Symbol, Expr>> =
        numbers.iter().map(|(name, value)| Some((*name, number(*value)?))).collect();
    let place = number(solution.equilibrium.evaluate(numbers).ok()?)?;
    let mut question = oscillator.clone();
    question.parameters = vec![];
    question.force = oscillator.force.substitute_all(&known?).ok()?;
    let parts = question.parts().ok()?;
    let (x, v) = (oscillator.coordinate, oscillator.velocity());
    let scale = if in_amplitude { root } else { Expr::one() };
    // f(x_eq + s y, s y')/s.
    let seen = |part: &Expr| -> Result<Expr, ExprError> {
        let position = &place + &(&scale * &Expr::from(x));
        let moved = part.substitute(x, &position)?;
        let moved = moved.substitute(v, &(&scale * &Expr::from(v)))?;
        Expr::divide(&moved, &scale)?.expand()
    };
    let at_rest = |part: &Expr| part.substitute(v, &Expr::zero())?.substitute(x, &Expr::zero());
    let restoring = seen(&parts.restoring).ok()?;
    let restoring = &restoring - &at_rest(&restoring).ok()?;
    // Without a linear part the whole force counts as restoring.
    let stiffness = restoring.differentiate(x).and_then(|slope| at_rest(&slope)).ok();
    let linear = match stiffness.filter(|stiffness| !stiffness.is_zero()) {
        Some(stiffness) => &stiffness * &Expr::from(x),
        None => restoring.clone(),
    };
    let damping = seen(&parts.damping).ok()?;
    let inertia = seen(&parts.inertia).ok()?;
    let force = match in_amplitude {
        true => {
            let viscous = &at_rest(&damping.differentiate(v).ok()?).ok()? * &Expr::from(v);
            let less = &(&number(factor_of_balance)? - &Expr::one()) * &viscous;
            Expr::sum([restoring, damping, inertia, less])
        }
        false => {
            let rest = Expr::sum([restoring, damping, inertia]) - &linear;
            &linear + &(&factor_number * &rest)
        }
    };
    let mut options = Options {
        method: Some(solution.method),
        order: Some(solution.order),
        small: in_amplitude.then(|| AmplitudeConvention::Initial.symbol().to_string()),
        ..Options::default()
    };
    question.force = force;
    question.about = Some(Expr::zero());
    if let Some(resonance) = resonance(solution) {
        options.resonance = Some((resonance.times_linear, resonance.times_driving));
        let [driving, less] = retuned(solution, resonance, numbers, factor_of_balance)?;
        let t = Symbol::new("t");
        let slower = &number(less / driving)? * &Expr::from(t);
        let forcing = seen(&parts.forcing).ok()?;
        let scale = in_amplitude.then_some((factor.sqrt(), power));
        let drives = forcing.terms().iter().map(|term| {
            let multiple = rate_of(term)? / driving;
            let (p, q) = options.resonance?;
            let resonant = (multiple * f64::from(p) - f64::from(q)).abs() < 1e-6;
            let left = number(drive_left(term, [x, v], resonant, factor, scale)?)?;
            Some(&left * &term.substitute(t, &slower).ok()?)
        });
        let drives: Option<Vec<Expr>> = drives.collect();
        question.force = &question.force + &Expr::sum(drives?);
    }
    question.force = question.force.expand().ok()?;
    let answer = solve(&question, &options).ok()?;
    let start = AmplitudeConvention::Initial.symbol();
    let numbers = numbers.get(&start).map(|value| (start, *value)).into_iter().collect();
    Some(Smaller { oscillator: question, solution: answer.off_cycle().unwrap_or(answer), numbers })
}

/// The angular frequency of the wave of a driven term.
fn rate_of(term: &Expr) -> Option<f64> {
    let t = Symbol::new("t");
    let (_, factors) = term.factors();
    let wave = factors.iter().find(|factor| factor.contains(t))?;
    let Node::Function(_, arguments) = wave.node() else {
        return None;
    };
    let rate = arguments[0].differentiate(t).ok()?.evaluate(&BTreeMap::new()).ok()?;
    Some(rate.abs())
}

/// The factor of a driven term in the smaller problem: a force far from resonance scales with the
/// amplitude, any other with the terms that balance it.
fn drive_left(
    term: &Expr,
    own: [Symbol; 2],
    resonant: bool,
    factor: f64,
    scale: Option<(f64, i32)>,
) -> Option<f64> {
    let degree = degree(term, own)?;
    let hard = degree == 0 && !resonant;
    let Some((scale, power)) = scale else {
        return Some(if hard { 1.0 } else { factor });
    };
    // The substitution has already given the power of the degree less one.
    let wanted = if hard { 0 } else { i32::max(degree - 1, power) };
    Some(scale.powi(wanted - (degree - 1)))
}

/// The lowest power of the coordinate and the velocity together; `None` if a function of them has
/// no series.
fn degree(term: &Expr, own: [Symbol; 2]) -> Option<i32> {
    /// Largest degree at which the series of a function may begin.
    const HIGHEST: u32 = 4;
    let (_, factors) = term.factors();
    let mut sum = ratio(0, 1);
    for factor in factors {
        let (base, exponent) = factor.base_and_exponent();
        match base.as_symbol().is_some_and(|name| own.contains(&name)) {
            true => sum += exponent.as_number()?,
            false if own.iter().any(|&name| factor.contains(name)) => {
                let series = taylor(factor, &own.map(|name| (name, ratio(0, 1))), HIGHEST).ok()?;
                let first = series.iter().position(|part| !part.is_zero())?;
                sum += ratio(i64::try_from(first).ok()?, 1);
            }
            false => {}
        }
    }
    sum.is_integer().then(|| sum.to_integer())?.to_i32()
}

//! He's max-min approach: omega^2 lies between the least and the largest of `f(x)/x`.
//!
//! Reference: J.-H. He, *Max-min approach to nonlinear oscillators*, Int. J. Nonlinear Sci. Numer.
//! Simul. 9 (2008) 207-210.
//!
//! ```text
//! x'' + [f(x)/x] x = 0:    min f/x < omega^2 < max f/x    over 0 < |x| <= A
//! omega^2 = (m lo + n hi)/(m + n) = lo + k (hi - lo),   k = n/(m + n)
//! no secular term in x'' + omega^2 x = omega^2 x - f(x), x = A cos(theta), fixes k
//! ```
//!
//! The last condition makes omega^2 the [shared integral](super::one_term); the bounds are what the
//! method adds, and where there are none, as for a force that is steeper than linear at rest, it
//! does not apply.
//!
//! Cost: the extremes of `f(x)/x` and one Fourier coefficient of the force.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::MaxMin), ..Options::default() };
//! let solution = solve(&duffing, &options)?;
//! assert_eq!(solution.law.frequency_squared().unwrap().to_string(), "1 + 3*eps*A^2/4");
//! let lines: Vec<String> = solution.derivation.iter().map(ToString::to_string).collect();
//! assert_eq!(lines[2], "at x = A:  q_A = 1 + eps*A^2");
//! assert_eq!(lines.last().unwrap(), "k = 3/4");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::collections::BTreeMap;

use num_traits::{Signed, Zero};

use super::one_term::{
    compiled, conservative_force, first_order_only, integral_law, law_of, require_odd,
    solve_by_integral,
};
use super::{Options, Reason, Refusal};
use crate::conservative::features::Features;
use crate::conservative::{split, take_powers};
use crate::decimal::decimal;
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::exact::{Polynomial, Rational};
use crate::expr::{Expr, Function, Node};
use crate::numeric::ode::root::find_root;
use crate::oscillator::Oscillator;
use crate::series::taylor::taylor;
use crate::solution::{Method, Note, Solution, note::BoundsHold};
use crate::symbol::letters::AMPLITUDE;
use crate::symbol::{Symbol, fresh, fresh_stem};

/// The frequency between the bounds of `f(x)/x`.
///
/// # Errors
/// A force that is not conservative or not odd, by its term; no finite bounds; an order above the
/// first.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    const METHOD: Method = Method::MaxMin;
    first_order_only(options, METHOD)?;
    let force = conservative_force(oscillator, options, METHOD)?;
    require_odd(oscillator, &force, METHOD)?;
    let coordinate = oscillator.coordinate;
    let (amplitude, x) = (Expr::symbol("A"), Expr::from(coordinate));
    let quotient = Expr::divide(&force, &x)?.expand()?;
    let at_rest = stiffness_at_rest(&quotient, &force, oscillator)
        .ok_or_else(|| Reason::Unbounded(quotient.to_string()))?;
    let at_turning =
        super::energy_balance::positive_amplitude(&quotient.substitute(coordinate, &amplitude)?)
            .unwrap_or_else(|| quotient.clone());
    let mut solution = solve_by_integral(oscillator, options, METHOD)?;
    let squared: DerivationFormula = Expr::symbol("omega").integer_power(2)?.into();
    let names = oscillator.names();
    let [q, rest, end, turn] =
        ["q", "q_rest", &format!("q_{AMPLITUDE}"), "q_s"].map(|name| fresh(name, &names));
    let [lo, hi, share] = ["lo", "hi", "k"].map(|name| Expr::from(fresh(name, &names)));
    let [rest, end] = [rest, end].map(Expr::from);
    let mut lines = vec![
        DerivationLine::equation(q, &quotient)
            .because(format!("{coordinate}'' + {q}*{coordinate} = 0 with the factor")),
        DerivationLine::equation(rest.clone(), &at_rest).because("at rest"),
        DerivationLine::equation(end.clone(), &at_turning)
            .because(format!("at {coordinate} = {AMPLITUDE}")),
    ];
    lines.extend(integral_law(oscillator, &force, &solution)?);
    let law = law_of(&solution);
    let between = |bounds: [&Expr; 2]| {
        DerivationLine::equation(squared.clone(), bounds[0] + &share * &(bounds[1] - bounds[0]))
    };
    let range = match turning_backs(oscillator, &quotient, &force) {
        None => {
            lines.push(
                between([&rest, &end])
                    .because(format!("while {q} runs from one to the other without turning back")),
            );
            if let Some((place, value)) = stationary_point(&quotient, coordinate)? {
                lines.push(DerivationLine::equal(place).because(format!(
                    "it turns back where the right side is positive and {AMPLITUDE} lies beyond"
                )));
                lines.push(DerivationLine::equation(turn, value).because("the bound there"));
            }
            let slope = quotient.differentiate(coordinate)?.expand()?;
            let mut letters = slope.symbols();
            letters.remove(&coordinate);
            BoundsHold::While {
                positive: of_one_sign(&slope, coordinate).then(|| letters.into_iter().collect()),
                slope,
                coordinate,
            }
        }
        Some(places) if places.is_empty() => {
            lines.push(
                between([&rest, &end])
                    .because(format!("{q} runs from one to the other without turning back")),
            );
            BoundsHold::Always
        }
        Some(places) => {
            let first = decimal(places[0].0);
            lines.push(between([&rest, &end]).because(format!("for {AMPLITUDE} up to {first}")));
            lines.extend(pieces(&places, &at_rest, oscillator, [&end, &lo, &hi])?);
            lines.push(between([&lo, &hi]).because(format!("for {AMPLITUDE} beyond {first}")));
            BoundsHold::UpTo(places[0].0)
        }
    };
    let turns = lines.iter().any(|line| line.equal.first() == Some(&lo.clone().into()));
    let exact_share = law.as_ref().filter(|_| !turns).and_then(|law| {
        let above = (law - &at_rest).expand().ok()?;
        quotient_of(&above, &(&at_turning - &at_rest).expand().ok()?)
    });
    if let Some(value) = exact_share {
        lines.push(DerivationLine::equation(share, value));
    } else if let (Some(law), true) = (law, turns) {
        lines.push(DerivationLine::equation(share, Expr::divide(&(law - &lo), &(&hi - &lo))?));
    }
    solution.derivation = lines;
    let bounds = Note::Bounds { at_rest, at_turning, range };
    solution.validity.insert(0, bounds);
    Ok(solution)
}

/// Largest number of extrema of `f(x)/x` that are written out.
const MOST_PIECES: usize = 4;

/// Extrema of `f(x)/x` for `x > 0` with their values, up to the end of the well; `None` if they
/// depend on parameters.
fn turning_backs(
    oscillator: &Oscillator,
    quotient: &Expr,
    force: &Expr,
) -> Option<Vec<(f64, f64)>> {
    /// The search covers so many decades on either side of 1, more than any quantity in SI units
    /// needs, with so many points in each.
    const DECADES: i32 = 24;
    const POINTS: i32 = 48;
    let coordinate = oscillator.coordinate;
    // A single power is monotonic.
    let varying = quotient.terms().iter().filter(|term| term.contains(coordinate));
    let powers: Vec<bool> = varying.map(|term| is_power(term, coordinate)).collect();
    if powers == [true] || powers.is_empty() {
        return Some(vec![]);
    }
    if force.symbols().into_iter().any(|symbol| symbol != coordinate) {
        return None;
    }
    let value = compiled(oscillator, quotient, &BTreeMap::new())?;
    let slope = compiled(oscillator, &quotient.differentiate(coordinate).ok()?, &BTreeMap::new())?;
    let place = |k: i32| 10_f64.powf(f64::from(k) / f64::from(POINTS));
    let mut places: Vec<f64> = (-DECADES * POINTS..=DECADES * POINTS).map(place).collect();
    // A grid may miss narrow features: they get points of their own.
    let features = Features::new(force, coordinate, &BTreeMap::new());
    let decades = (-DECADES..DECADES).map(|k| [place(k * POINTS), place((k + 1) * POINTS)]);
    for feature in decades.flat_map(|[low, high]| features.between(low, high)) {
        places.extend((-8..=8).map(|k| feature.place + 0.5 * f64::from(k) * feature.width));
    }
    places.retain(|x| *x > 0.0 && x.is_finite());
    places.sort_by(f64::total_cmp);
    places.dedup();
    let mut found = Vec::new();
    let (mut before, mut place_before) = (f64::NAN, 0.0);
    // A force that pushes away at rest has its well beyond the place where it begins to pull back.
    let mut pulls = false;
    for x in places {
        let rate = slope(x);
        pulls |= value(x) > 0.0;
        if (pulls && value(x) <= 0.0) || !value(x).is_finite() || found.len() > MOST_PIECES {
            break;
        }
        // Near rest the slope is lost in rounding: it counts once f/x has moved by more than that.
        let visible = (rate * x).abs() > 1e-9 * value(x).abs();
        if visible {
            if before * rate < 0.0
                && let Ok(root) = find_root(&slope, place_before, x)
            {
                found.push((root, value(root)));
            }
            (before, place_before) = (rate, x);
        }
    }
    Some(found)
}

/// Whether a sum of products of powers has one sign for positive symbols.
fn of_one_sign(sum: &Expr, coordinate: Symbol) -> bool {
    let positive = |factor: &Expr| {
        let (base, exponent) = factor.base_and_exponent();
        let known =
            base.as_symbol().is_some() || base.symbols().is_empty() && !base.has_leading_minus();
        let size = matches!(base.node(), Node::Function(Function::Absolute, arguments) if *arguments == [Expr::from(coordinate)]);
        (known || size) && exponent.as_number().is_some()
    };
    let terms = sum.terms();
    let signs = terms.iter().map(Expr::has_leading_minus);
    let first = terms.first().is_some_and(Expr::has_leading_minus);
    signs.into_iter().all(|minus| minus == first)
        && terms.iter().all(|term| term.factors().1.iter().all(positive))
}

/// Whether a term is a power of the coordinate times a constant.
fn is_power(term: &Expr, coordinate: Symbol) -> bool {
    let (mut outside, mut inside) = split(term, coordinate);
    take_powers(&mut inside, &mut outside, coordinate).is_some() && inside.is_empty()
}

/// The bounds beyond each place where `f(x)/x` turns back: the least and the largest so far, or the
/// value at `x = A`.
fn pieces(
    places: &[(f64, f64)],
    at_rest: &Expr,
    oscillator: &Oscillator,
    [end, lo, hi]: [&Expr; 3],
) -> Result<Vec<DerivationLine>, Refusal> {
    let rest = compiled(oscillator, at_rest, &BTreeMap::new()).map_or(f64::NAN, |value| value(0.0));
    let (mut least, mut largest) = (rest, rest);
    let taken = oscillator.names();
    let (q, [l, h]) = (fresh("q", &taken), ["L", "H"].map(|letter| fresh_stem(letter, &taken)));
    let mut lines = Vec::new();
    for (index, &(place, value)) in places.iter().enumerate() {
        if index == MOST_PIECES {
            lines.push(DerivationLine::words(format!(
                "{q} goes on turning back beyond {}: left out",
                decimal(place)
            )));
            break;
        }
        (least, largest) = (least.min(value), largest.max(value));
        let number = index + 1;
        let [least_name, largest_name] =
            [&l, &h].map(|letter| Symbol::new(&format!("{letter}{number}")));
        lines.push(DerivationLine::words(format!(
            "{x} = {}: {q} turns back at {}; up to there the least is {least_name} = {}, the largest {largest_name} = {}",
            decimal(place),
            decimal(value),
            decimal(least),
            decimal(largest),
            x = oscillator.coordinate
        )));
        let range = match places.get(index + 1) {
            Some((next, _)) => {
                format!("for {AMPLITUDE} from {} to {}", decimal(place), decimal(*next))
            }
            None => format!("for {AMPLITUDE} beyond {}", decimal(place)),
        };
        let minimum = Expr::function(Function::Minimum, vec![least_name.into(), end.clone()])?;
        let maximum = Expr::function(Function::Maximum, vec![largest_name.into(), end.clone()])?;
        lines.push(DerivationLine::equation(lo, minimum).because(range));
        lines.push(DerivationLine::equation(hi, maximum));
    }
    Ok(lines)
}

/// The stationary point of `a + b x^m + c x^n` as `x^(n-m) = -m b/(n c)`, and the value there.
fn stationary_point(
    quotient: &Expr,
    coordinate: Symbol,
) -> Result<Option<(Vec<DerivationFormula>, Expr)>, Refusal> {
    let Some(polynomial) = quotient.to_polynomial(&mut |_| None)? else {
        return Ok(None);
    };
    let mut by_power: BTreeMap<i32, Polynomial> = BTreeMap::new();
    for (monomial, number) in polynomial.terms() {
        let power = by_power.entry(monomial.exponent(coordinate)).or_insert_with(Polynomial::zero);
        power.add_term(monomial.without(coordinate), number.clone());
    }
    let constant = by_power.remove(&0).unwrap_or_else(Polynomial::zero);
    let powers: Vec<(i32, Polynomial)> = by_power.into_iter().collect();
    let [(m, b), (n, c)] = powers.as_slice() else {
        return Ok(None);
    };
    let (b, c) = (Expr::from(b), Expr::from(c));
    let number = |power: i32| Expr::from(i64::from(power));
    let ratio = Expr::divide(&-&(number(*m) * &b), &(number(*n) * &c))?;
    let place = Expr::from(coordinate).integer_power(i64::from(n - m))?;
    // b x^m + c x^n = b x^m (1 - m/n) there.
    let share = Expr::divide(&number(n - m), &number(*n))?;
    let power = Expr::power(&ratio, &Expr::divide(&number(*m), &number(n - m))?)?;
    let value = Expr::from(&constant) + share * b * power;
    Ok(Some((vec![place.into(), ratio.into()], value)))
}

fn quotient_of(above: &Expr, below: &Expr) -> Option<Expr> {
    if below.is_zero() {
        return None;
    }
    let quotient = Expr::divide(above, below).ok()?;
    // The quotient of two sums that are multiples of one another is a number.
    match (above.terms(), below.terms()) {
        ([_], [_]) => quotient.expand().ok(),
        _ => Some(quotient),
    }
}

/// The limit of `f(x)/x` at rest, where it is finite.
fn stiffness_at_rest(quotient: &Expr, force: &Expr, oscillator: &Oscillator) -> Option<Expr> {
    if let Ok(value) = quotient.substitute(oscillator.coordinate, &Expr::zero()) {
        return Some(value);
    }
    let coordinate = oscillator.coordinate;
    if let Ok(parts) = taylor(force, &[(coordinate, Rational::zero())], 1) {
        let slope = Expr::divide(parts.get(1)?, &Expr::from(coordinate)).ok()?;
        return slope.expand().ok();
    }
    // Powers of |x| above zero vanish at rest, whatever they are.
    let term = |term: &Expr| {
        let (mut outside, mut inside) = split(term, coordinate);
        let power = take_powers(&mut inside, &mut outside, coordinate)?;
        match (inside.is_empty(), power.exponent.is_positive()) {
            (true, true) => Some(Expr::zero()),
            (true, false) if power.exponent.is_zero() && !power.odd => Some(outside),
            _ => None,
        }
    };
    let terms = quotient.terms().iter().map(term).collect::<Option<Vec<_>>>()?;
    Some(Expr::sum(terms))
}

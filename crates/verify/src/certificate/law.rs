//! The law of a formula as text, compared with its numbers.
//!
//! In: `omega^2 = 1 - A^2/8`, with definitions of other symbols after commas, and the values of the
//! symbols. Out: the number that it gives, in balls if every function of it has a value in balls,
//! else to twelve digits. A text of another form counts as words and is not compared.

use std::collections::BTreeMap;

use super::force::along;
use super::formula::JudgedFormula;
use super::fourier_series::{FourierSeries, WORKING};
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::rational::from_f64;
use crate::expr::{Expr, parse_expression};
use crate::solution::law::DisplayedLaw;
use crate::solution::{Definition, Solution};
use crate::symbol::Symbol;
use crate::symbol::letters::FREQUENCY;
use crate::values::Values;

/// Greatest length of a law; a longer text counts as words.
const LONGEST: usize = 20_000;

/// Number of binary digits behind the point below which the numbers of a formula do not distinguish
/// laws.
const FEWEST_BITS: usize = 40;

/// The law of the frequency as text, and the values of the symbols in it.
pub(super) fn of_frequency(solution: &Solution, at: &Values) -> (String, Values) {
    // Rounded coefficients are printed with six digits; here all digits are needed.
    let exactly = match solution.law.in_one_line() {
        _ if !solution.numerical || solution.slow().is_some() => None,
        DisplayedLaw::Squared(law) => Some(("^2", Expr::from(law))),
        DisplayedLaw::Frequency(law) => Some(("", Expr::from(law))),
        DisplayedLaw::Closed(form) if form.squared => Some(("^2", form.value.clone())),
        DisplayedLaw::Closed(form) => Some(("", form.value.clone())),
        _ => None,
    };
    let law = match exactly {
        Some((power, value)) => {
            let name = format!("{FREQUENCY}{power}");
            with_definitions(solution, &name, &value, |definition| definition.meaning.to_string())
        }
        None => solution.formula(),
    };
    let values = values_in(&law, at);
    (law, values)
}

/// An equation of an answer with the definitions that its right side needs.
pub(super) fn with_definitions(
    solution: &Solution,
    name: &str,
    value: &Expr,
    meaning: impl Fn(&Definition) -> String,
) -> String {
    let definitions = solution.definitions_behind(value.symbols()).into_iter();
    let definitions =
        definitions.map(|definition| format!(", {} = {}", definition.symbol, meaning(definition)));
    std::iter::once(format!("{name} = {value}")).chain(definitions).collect()
}

/// Selects the values of the symbols that occur in a law, under the names that they have there;
/// none for words.
pub(super) fn values_in(law: &str, at: &Values) -> Values {
    let letters = read(law).map(|(_, value)| value.symbols()).unwrap_or_default();
    let mut values = Values::default();
    for (name, value) in at.iter() {
        let name = Symbol::new(name.written());
        if letters.contains(&name) {
            // A value is one.
            let _ = values.insert(name, value.clone());
        }
    }
    values
}

/// The left side of a law, and its right side with the definitions substituted.
fn read(law: &str) -> Option<(String, Expr)> {
    if law.len() > LONGEST {
        return None;
    }
    let mut equations = vec![];
    for equation in equations_of(law) {
        let (name, value) = equation.split_once('=')?;
        equations.push((name.trim().to_owned(), parse_expression(value).ok()?));
    }
    let mut equations = equations.into_iter();
    let (name, mut value) = equations.next()?;
    // A definition may use those before it.
    for (name, meaning) in equations.rev() {
        let symbol = parse_expression(&name).ok()?.as_symbol()?;
        value = value.substitute(symbol, &meaning).ok()?;
    }
    Some((name, value))
}

/// The parts between the commas outside of parentheses.
fn equations_of(law: &str) -> Vec<&str> {
    let (mut depth, mut begin, mut parts) = (0_i64, 0, vec![]);
    for (place, letter) in law.char_indices() {
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&law[begin..place]);
                begin = place + 1;
            }
            _ => {}
        }
    }
    parts.push(&law[begin..]);
    parts
}

/// The left side of a law, and its right side with definitions and values substituted; `None` for
/// words.
pub(super) fn with_values(law: &str, values: &Values) -> Option<(String, Expr)> {
    let (name, value) = read(law)?;
    let values: BTreeMap<Symbol, Expr> =
        values.iter().map(|(name, value)| (name, value.clone())).collect();
    Some((name, value.substitute_all(&values).ok()?))
}

/// Evaluates the frequency by the law of a formula; `None` for words, and if the law has no
/// positive value.
pub(super) fn frequency(formula: &JudgedFormula) -> Option<Ball> {
    let (name, value) = with_values(&formula.law, &formula.values)?;
    let value = number(&value)?;
    match name.strip_prefix(formula.letters.frequency.name())? {
        "" => Some(value),
        "^2" => WORKING.root(&value, 2),
        _ => None,
    }
}

/// The value of an expression without symbols, in balls; `None` for a function that has none in
/// balls.
pub(super) fn exact_number(expression: &Expr) -> Option<Ball> {
    let nothing = FourierSeries::constant(Ball::zero());
    let is_constant = expression.symbols().is_empty();
    is_constant.then(|| along(expression, &nothing).ok().map(|series| series.at_zero())).flatten()
}

/// The value of an expression without symbols, in balls; `None` if it has none.
pub(super) fn number(expression: &Expr) -> Option<Ball> {
    /// The relative error of a double, for functions that have no value in balls.
    const ROUNDING: f64 = 1e-12;
    if let Some(exact) = exact_number(expression) {
        return Some(exact);
    }
    let double = expression.evaluate(&BTreeMap::new()).ok()?;
    let mut ball = WORKING.fraction(&from_f64(double)?);
    ball.radius += Bound::of_nearest(ROUNDING * double.abs());
    Some(ball)
}

/// Returns whether the law was read and gives the frequency of the formula to its last digits;
/// `false` for words.
///
/// # Errors
/// A law that gives another one.
pub(super) fn law_matches_frequency(
    formula: &JudgedFormula,
    bits: usize,
) -> Result<bool, &'static str> {
    let exact = frequency(formula).filter(|_| bits >= FEWEST_BITS);
    let Some(exact) = exact else { return Ok(false) };
    match is_rounded(&exact, &formula.frequency_ball(bits), bits) {
        true => Ok(true),
        false => {
            Err("a formula whose law, at its values, gives another frequency than its numbers")
        }
    }
}

/// Returns whether the law of a displacement was read and gives the coefficients of the formula to
/// their last digits; `false` for words.
///
/// # Errors
/// A law that gives others.
pub(super) fn hold_displacement(
    exact: Option<&FourierSeries>,
    formula: &JudgedFormula,
    bits: usize,
) -> Result<bool, &'static str> {
    let unit = Bound::power_of_two(-(bits as i32));
    let Some(exact) = exact.filter(|exact| bits >= FEWEST_BITS && exact.tail <= unit) else {
        return Ok(false);
    };
    let own = formula.motion(bits);
    let agree = |k: usize| {
        is_rounded(&exact.cosine(k), &own.cosine(k), bits)
            && is_rounded(&exact.sine(k), &own.sine(k), bits)
    };
    match (0..exact.length().max(own.length())).all(agree) {
        true => Ok(true),
        false => Err("a formula whose law, at its values, gives another motion than its numbers"),
    }
}

/// Returns whether a number is one of a ball, rounded to so many binary digits.
fn is_rounded(exact: &Ball, number: &Ball, bits: usize) -> bool {
    let apart = WORKING.difference(exact, number);
    WORKING.distance_from_zero(&apart) <= 2.0_f64.powi(1 - bits as i32)
}

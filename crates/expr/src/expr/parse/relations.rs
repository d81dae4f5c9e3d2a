//! Several equations in one text, inequalities, and events.
//!
//! ```text
//! equations  = sum [ "=" sum ] { ";" sum [ "=" sum ] }
//! inequality = sum { ("<" | ">" | "<=" | ">=") sum }
//! event      = [ "when" ] sum ("<" | ">" | "<=" | ">=" | "=") sum ":" name "=" sum { ";" name "=" sum }
//! ```

use super::{Expr, ParseError, Parser, TokenKind, parse_expression};
use crate::symbol::Symbol;

/// The states that an event sets, with their new values.
pub type Assignments = Vec<(Symbol, Expr)>;

/// Reads an event of a motion with these states: a condition, a colon, and what is set where it comes
/// true. The word `when` before the condition may be left out.
///
/// Returns the expression that grows through zero where the condition comes true, `x - 1` for `x > 1`;
/// whether it counts as well where that falls through zero, as for `x = 1`; and the states that are set with
/// their new values.
///
/// # Errors
/// See [`ParseError`]; also for a condition without a state or the time, for a name that is not a state, and
/// for an event that changes nothing.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::parse_event;
///
/// let kick = parse_event("x < 0: x' = -e*x'; y = y + 1", &["x".into(), "y".into(), "x'".into()])?;
/// let (guard, both_ways, assignments) = kick;
/// assert_eq!((guard.to_string(), both_ways), ("-x".to_owned(), false));
/// assert_eq!(assignments[0].1.to_string(), "-e*x'");
/// assert!(parse_event("x = 0: z = 1", &["x".into()]).is_err());
/// # Ok::<(), lindstedt::expr::ParseError>(())
/// ```
pub fn parse_event(text: &str, states: &[Symbol]) -> Result<(Expr, bool, Assignments), ParseError> {
    let first = text.len() - text.trim_start().len();
    let spoken = text[first..].strip_prefix("when").filter(|rest| rest.starts_with(' '));
    let first = spoken.map_or(first, |rest| text.len() - rest.len());
    let Some(colon) = text.find(':') else {
        let help = "an event is a condition, a colon and what is set, such as `x > 1: x' = -x'`";
        return Err(ParseError::new(text, 0..text.len(), "no `:` behind the condition", help));
    };
    let condition = &text[first..colon.max(first)];
    let own = |error: ParseError| error.within(text, first);
    let (guard, both_ways) = condition_of_event(condition).map_err(own)?;
    let names = guard.symbols();
    if let Some(other) = names.iter().find(|name| name.primes() > 0 && !states.contains(name)) {
        let message = format!("`{other}` is not a state");
        return Err(ParseError::new(text, first..colon, &message, &listed(states)));
    }
    if !names.iter().any(|name| states.contains(name) || name.name() == "t") {
        let message = "this condition never changes";
        let help = format!("it needs the time `t` or a state, {}", listed(states));
        return Err(ParseError::new(text, first..colon, message, &help));
    }
    Ok((guard, both_ways, assignments(text, colon + 1, states)?))
}

/// The states, for a message.
fn listed(states: &[Symbol]) -> String {
    let names: Vec<String> = states.iter().map(|name| format!("`{name}`")).collect();
    format!("one of {}", names.join(", "))
}

/// The expression that grows through zero where a condition comes true, and whether it may fall as well.
fn condition_of_event(text: &str) -> Result<(Expr, bool), ParseError> {
    let relation = |letter: char| matches!(letter, '<' | '>' | '≤' | '≥' | '=');
    let Some(sign) = text.find(relation) else {
        let help = "a condition compares two expressions, such as `x > 1` or `x = 0`";
        return Err(ParseError::new(text, 0..text.len(), "no `<`, `>` or `=`", help));
    };
    if !text[sign..].starts_with('=') {
        let gaps = parse_inequality(text)?;
        return match <[Expr; 1]>::try_from(gaps) {
            Ok([gap]) => Ok((gap, false)),
            Err(_) => {
                let help = "give an event for each of them";
                Err(ParseError::new(text, 0..text.len(), "several conditions in one", help))
            }
        };
    }
    let sides = [0..sign, sign + 1..text.len()].map(|range| {
        if text[range.clone()].trim().is_empty() {
            let help = "a condition has an expression on each side, such as `x = 0`";
            let place = sign..sign + 1;
            return Err(ParseError::new(text, place, "a side of the condition is empty", help));
        }
        let first = range.start;
        parse_expression(&text[range]).map_err(|error| error.within(text, first))
    });
    let [left, right] = sides;
    Ok((left? - right?, true))
}

/// The assignments in a text from this byte on.
fn assignments(text: &str, from: usize, states: &[Symbol]) -> Result<Assignments, ParseError> {
    let mut assignments: Vec<(Symbol, Expr)> = Vec::new();
    let mut first = from;
    for part in text[from..].split(';') {
        let start = first + part.len() - part.trim_start().len();
        let place = start..(first + part.trim_end().len()).max(start);
        first += part.len() + 1;
        if place.is_empty() {
            continue;
        }
        let part = &text[place.clone()];
        let error =
            |message: &str, help: &str| Err(ParseError::new(text, place.clone(), message, help));
        let Some((name, value)) = part.split_once('=') else {
            return error("nothing is set here", "an event sets a state, such as `x' = -x'`");
        };
        let name = name.trim_end();
        let Some(state) = states.iter().find(|state| state.name() == name) else {
            let place = start..start + name.len().max(1);
            let message = format!("`{name}` is not a state, so that an event cannot set it");
            return Err(ParseError::new(text, place, &message, &listed(states)));
        };
        if value.contains(',') && parse_expression(value).is_err() {
            return error("this is not one value", "several states are set with `;` between them");
        }
        let offset = place.end - value.len();
        let value = parse_expression(value).map_err(|error| error.within(text, offset))?;
        if let Some(other) =
            value.symbols().iter().find(|name| name.primes() > 0 && !states.contains(name))
        {
            return error(&format!("`{other}` is not a state"), &listed(states));
        }
        if assignments.iter().any(|(known, _)| known == state) {
            return error(&format!("`{state}` is set twice"), "");
        }
        assignments.push((*state, value));
    }
    if assignments.iter().all(|(state, value)| value.as_symbol() == Some(*state)) {
        let message = "this event changes nothing";
        let help = "behind the colon stands what is set, such as `x' = -x'`";
        return Err(ParseError::new(text, from - 1..text.len(), message, help));
    }
    Ok(assignments)
}

/// Reads equations that are separated by `;`, such as `x'' + x - y = 0; y'' + y - x = 0`, each as
/// its left and its right side, which is 0 if there is no equals sign.
///
/// # Errors
/// See [`ParseError`]; its place is that in the whole text.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::parse_equations;
///
/// let [first, second] = &parse_equations("x'' + 2*x = y; y'' + 2*y - x")?[..] else { panic!() };
/// assert_eq!((first.0.to_string(), first.1.to_string()), ("x'' + 2*x".to_owned(), "y".to_owned()));
/// assert!(second.1.is_zero() && parse_equations("x'' = y; y'' = 2 x").is_err());
/// # Ok::<(), lindstedt::expr::ParseError>(())
/// ```
pub fn parse_equations(text: &str) -> Result<Vec<(Expr, Expr)>, ParseError> {
    let mut equations = Vec::new();
    let mut first = 0;
    let count = text.trim_end().trim_end_matches(';').split(';').count();
    for part in text.split(';').take(count) {
        let own = |error: ParseError| error.within(text, first);
        equations.push(sides(part).map_err(own)?);
        first += part.len() + 1;
    }
    Ok(equations)
}

/// Reads an inequality, such as `x < 1` or `-1 < x < 1`, and returns the expressions that are
/// positive where it holds: `1 - x`, and for each further sign another one. `<=` is read as `<`.
///
/// # Errors
/// See [`ParseError`]; also for a text without `<` or `>`.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::parse_inequality;
///
/// let [gap] = &parse_inequality("x > Z*sin(t)")?[..] else { panic!() };
/// assert_eq!(gap.to_string(), "x - Z*sin(t)");
/// assert_eq!(parse_inequality("-1 < x <= 1")?.len(), 2);
/// assert!(parse_inequality("x = 1").is_err());
/// # Ok::<(), lindstedt::expr::ParseError>(())
/// ```
pub fn parse_inequality(text: &str) -> Result<Vec<Expr>, ParseError> {
    let is_sign = |letter: char| matches!(letter, '<' | '>' | '≤' | '≥');
    if !text.contains(is_sign) {
        let (message, help) = ("no `<` or `>`", "an inequality such as `x < 1` is expected");
        return Err(ParseError::new(text, 0..text.len(), message, help));
    }
    let (mut sides, mut signs, mut rest) = (Vec::new(), Vec::new(), text);
    loop {
        let first = text.len() - rest.len();
        let end = rest.find(is_sign).unwrap_or(rest.len());
        if rest[..end].trim().is_empty() {
            let span = first..(first + end).max(first + 1).min(text.len());
            let help = "an inequality has an expression on each side, such as `x < 1`";
            return Err(ParseError::new(text, span, "a side of the inequality is empty", help));
        }
        let side = parse_expression(&rest[..end]).map_err(|error| error.within(text, first))?;
        sides.push(side);
        let Some(sign) = rest[end..].chars().next() else { break };
        signs.push(matches!(sign, '<' | '≤'));
        rest = &rest[end + sign.len_utf8()..];
        rest = rest.strip_prefix('=').unwrap_or(rest);
    }
    let positive = sides.windows(2).zip(&signs).map(|(pair, less)| match less {
        true => &pair[1] - &pair[0],
        false => &pair[0] - &pair[1],
    });
    Ok(positive.collect())
}

/// Reads the two sides of an equation.
fn sides(text: &str) -> Result<(Expr, Expr), ParseError> {
    let mut parser = Parser::new(text, true)?;
    let left = parser.sum()?;
    let mut right = Expr::zero();
    if parser.peek() == TokenKind::Equals {
        parser.advance();
        right = parser.sum()?;
    }
    match parser.peek() {
        TokenKind::End => Ok((left, right)),
        TokenKind::Equals => {
            Err(parser.error(parser.token().span(), "a second `=`", "an equation has one"))
        }
        _ => Err(parser.unexpected()),
    }
}

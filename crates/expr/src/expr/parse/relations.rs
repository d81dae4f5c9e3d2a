//! Several equations in one text, and inequalities.
//!
//! ```text
//! equations  = sum [ "=" sum ] { ";" sum [ "=" sum ] }
//! inequality = sum { ("<" | ">" | "<=" | ">=") sum }
//! ```

use super::{Expr, ParseError, Parser, TokenKind, parse_expression};

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

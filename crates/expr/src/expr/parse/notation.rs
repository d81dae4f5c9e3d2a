//! Notations of print and of other programs, put into the grammar where they mean one thing only:
//! `ẍ + 2ζẋ + ω₀²x = 0` is `x'' + 2*zeta*x' + omega0^2*x = 0`.
//!
//! A syntax error knows the meaning of its place, if there is only one. The text is read, corrected
//! at the first such error, and read again, until there is none. An ambiguous notation stays an
//! error: `k(x)` is a product or a function, `sin^-1(x)` an inverse or a reciprocal, `2e` a product
//! or half an exponent.

use std::borrow::Cow;
use std::ops::Range;

use super::error::ParseError;
use super::{parse_equation, parse_expression};
use crate::expr::Function;

/// The longest text that is corrected, in bytes, and the largest number of corrections, each of
/// which reads it anew.
const LONGEST: usize = 4096;

/// Returns an equation of motion with the notations of print in the spelling of the grammar; the
/// text itself if there are none. A text that cannot be made an equation is returned as far as it
/// could be corrected.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::equation_in_grammar;
///
/// assert_eq!(equation_in_grammar("ẍ + 2ζẋ + sin x = 0"), "x'' + 2*zeta*x' + sin(x) = 0");
/// assert_eq!(equation_in_grammar("x'' + k(x) = 0"), "x'' + k(x) = 0");
/// ```
pub fn equation_in_grammar(text: &str) -> Cow<'_, str> {
    corrected(text, |text| parse_equation(text).err())
}

/// Returns an expression with the notations of print in the spelling of the grammar; the text
/// itself if there are none.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::expression_in_grammar;
///
/// assert_eq!(expression_in_grammar("2π/3"), "2*pi/3");
/// assert_eq!(expression_in_grammar("60deg"), "60*pi/180");
/// ```
pub fn expression_in_grammar(text: &str) -> Cow<'_, str> {
    corrected(text, |text| parse_expression(text).err())
}

fn corrected<'a>(text: &'a str, error: impl Fn(&str) -> Option<ParseError>) -> Cow<'a, str> {
    let mut corrected = Cow::Borrowed(text);
    for _ in 0..LONGEST {
        let found = error(&corrected).and_then(|error| error.correction);
        match found {
            Some(correction) if corrected.len() <= LONGEST => {
                let (part, replacement) = *correction;
                corrected.to_mut().replace_range(part, &replacement);
            }
            _ => break,
        }
    }
    corrected
}

/// The spelling of a character of a typeset formula in the grammar.
pub(super) fn spelling(letter: char) -> Option<&'static str> {
    Some(match letter {
        '\u{2212}' | '\u{2013}' | '\u{2014}' | '\u{2010}' | '\u{2011}' => "-",
        '×' | '·' | '⋅' | '∙' | '•' | '∗' => "*",
        '÷' | '∕' | '⁄' => "/",
        '⁰' => "^0",
        '¹' => "^1",
        '²' => "^2",
        '³' => "^3",
        '⁴' => "^4",
        '⁵' => "^5",
        '⁶' => "^6",
        '⁷' => "^7",
        '⁸' => "^8",
        '⁹' => "^9",
        '₀' => "0",
        '₁' => "1",
        '₂' => "2",
        '₃' => "3",
        '₄' => "4",
        '₅' => "5",
        '₆' => "6",
        '₇' => "7",
        '₈' => "8",
        '₉' => "9",
        '½' => "1/2",
        '′' | '’' | '‘' | '´' | '\u{307}' => "'",
        '″' | '“' | '”' | '"' | '\u{308}' => "''",
        'ẋ' => "x'",
        'ẍ' => "x''",
        'ẏ' => "y'",
        'ÿ' => "y''",
        'ż' => "z'",
        'ü' => "u''",
        '√' => "sqrt(x)",
        '°' => "deg",
        'α' => "alpha",
        'β' => "beta",
        'γ' => "gamma",
        'δ' => "delta",
        'ε' | 'ϵ' => "eps",
        'ζ' => "zeta",
        'η' => "eta",
        'θ' | 'ϑ' => "theta",
        'κ' => "kappa",
        'λ' => "lambda",
        'Λ' => "Lambda",
        'μ' | 'µ' => "mu",
        'ν' => "nu",
        'ξ' => "xi",
        'π' => "pi",
        'ρ' => "rho",
        'σ' => "sigma",
        'τ' => "tau",
        'φ' | 'ϕ' => "phi",
        'χ' => "chi",
        'ψ' => "psi",
        'ω' => "omega",
        'Ω' | '\u{2126}' => "Omega",
        '\u{a0}' | '\u{2009}' | '\u{202f}' | '\u{3000}' => " ",
        '\u{ff1d}' => "=",
        '\u{ff08}' | '[' | '{' => "(",
        '\u{ff09}' | ']' | '}' => ")",
        _ => return None,
    })
}

/// The advice on a character, as it stands below the text; empty if there is none.
pub(super) fn help(letter: char) -> String {
    match spelling(letter) {
        Some(" ") => "try a plain blank".to_owned(),
        Some(spelling) => format!("try `{spelling}`"),
        None => String::new(),
    }
}

/// The part of the text that belongs to a character outside the grammar, and its spelling; `None`
/// if it is ambiguous. Everything left of it is in the grammar.
pub(super) fn meaning(text: &str, start: usize, letter: char) -> Option<(Range<usize>, String)> {
    let end = start + letter.len_utf8();
    let (before, after) = (&text[..start], &text[end..]);
    let here = |spelling: &str| Some((start..end, spelling.to_owned()));
    match letter {
        '|' => absolute_value(text, start),
        '√' => root(after).map(|(length, spelling)| (start..end + length, spelling)),
        '⁰'..='⁹' | '²' | '³' | '¹' | '⁻' => {
            let run = text[start..].find(|letter| superscript(letter).is_none());
            let run = run.map_or(text.len(), |length| start + length);
            let exponent: String = text[start..run].chars().filter_map(superscript).collect();
            let named = before.ends_with(|letter: char| {
                letter.is_ascii_alphanumeric() || matches!(letter, ')' | '\'')
            });
            match exponent.strip_prefix('-') {
                _ if !named => None,
                None => Some((start..run, format!("^{exponent}"))),
                // On a function it could mean the inverse or the reciprocal.
                Some(_) if Function::from_name(last_name(before)).is_some() => None,
                Some(digits) if digits.parse::<u32>().is_ok() => {
                    Some((start..run, format!("^(-{digits})")))
                }
                Some(_) => None,
            }
        }
        '₀'..='₉' => (!last_name(before).is_empty()).then(|| here(spelling(letter)?))?,
        '½' => None,
        _ => {
            let spelling = spelling(letter)?;
            if !spelling.starts_with(|letter: char| letter.is_ascii_alphabetic()) {
                return here(spelling);
            }
            // The character is a letter: an adjoining letter or digit is another factor, unless it
            // is its index.
            let times_before = if last_name(before).is_empty() { "" } else { "*" };
            let times_after = match after.chars().next() {
                Some(next) if next.is_ascii_alphabetic() => match is_factor(after) {
                    true => "*",
                    false => return None,
                },
                Some(next) if next.is_alphabetic() && superscript(next).is_none() => "*",
                _ => "",
            };
            here(&format!("{times_before}{spelling}{times_after}"))
        }
    }
}

/// The digit or sign of a raised character.
fn superscript(letter: char) -> Option<char> {
    match letter {
        '⁻' => Some('-'),
        _ => spelling(letter)?.strip_prefix('^')?.chars().next(),
    }
}

/// The name that a text ends with, without primes; empty where it ends with something else.
fn last_name(text: &str) -> &str {
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let run = &text[text.trim_end_matches(is_part).len()..];
    let digits = run.trim_start_matches(|letter: char| letter.is_ascii_digit());
    // `2x` ends with the name x, `1e5` with a number.
    match digits.len() < run.len() && digits.starts_with(['e', 'E']) {
        true => "",
        false => digits,
    }
}

/// Whether a text begins with a usual coordinate or a function, which cannot be an index of the
/// letter before it; `n` can be one.
fn is_factor(text: &str) -> bool {
    let length = text.find(|letter: char| !letter.is_ascii_alphabetic()).unwrap_or(text.len());
    let name = &text[..length];
    ["x", "y", "z", "q", "u"].contains(&name) || Function::from_name(name).is_some()
}

/// Reads the operand after a root sign, `√(...)`, `√2` or `√x`: returns its length and the call of
/// `sqrt`.
fn root(after: &str) -> Option<(usize, String)> {
    if after.starts_with('(') {
        return Some((0, "sqrt".to_owned()));
    }
    let length = after
        .find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '.')
        .unwrap_or(after.len());
    (length > 0).then(|| (length, format!("sqrt({})", &after[..length])))
}

/// A pair of bars with one operand or sum between them.
fn absolute_value(text: &str, open: usize) -> Option<(Range<usize>, String)> {
    let close = open + 1 + text[open + 1..].find('|')?;
    let inner = text[open + 1..close].trim();
    let mut depth = 0_i32;
    let is_balanced = inner.chars().all(|letter| {
        depth += i32::from(letter == '(') - i32::from(letter == ')');
        depth >= 0
    });
    let is_operator = |letter: char| "+-*/^=,".contains(letter);
    let is_whole = !inner.is_empty() && !inner.ends_with(is_operator) && !inner.contains('=');
    (is_balanced && depth == 0 && is_whole).then(|| (open..close + 1, format!("abs({inner})")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notations_of_print_mean_what_they_say() {
        for (typed, read) in [
            ("x'' + 2x = 0", "x'' + 2*x = 0"),
            ("x'' + 2(x + x^3) = 0", "x'' + 2*(x + x^3) = 0"),
            ("x'' + (1 + x)(1 - x)x = 0", "x'' + (1 + x)*(1 - x)*x = 0"),
            ("ẍ − μ(1−x²)ẋ + x = 0", "x'' - mu*(1-x^2)*x' + x = 0"),
            ("ẍ + 2ζω₀ẋ + ω₀²x = 0", "x'' + 2*zeta*omega0*x' + omega0^2*x = 0"),
            ("θ̈ + (g/L) sin θ = 0", "theta'' + (g/L)*sin(theta) = 0"),
            ("φ'' + sin φ = 0", "phi'' + sin(phi) = 0"),
            ("x″ + εx³ = 0", "x'' + eps*x^3 = 0"),
            ("x'' + x¹² = 0", "x'' + x^12 = 0"),
            ("x'' + x⁻¹ = 0", "x'' + x^(-1) = 0"),
            ("x''(t) + sin(x(t)) = 0", "x'' + sin(x) = 0"),
            ("d2x/dt2 + dx/dt + x = 0", "x'' + x' + x = 0"),
            ("d^2x/dt^2 + x = 0", "x'' + x = 0"),
            ("\\ddot{x} + 0.1\\dot{x} + x = 0", "x'' + 0.1*x' + x = 0"),
            ("x\" + |x'|x' + x = 0", "x'' + abs(x')*x' + x = 0"),
            ("x'' + sign(x') + arctan(x) = 0", "x'' + sgn(x') + atan(x) = 0"),
            ("x'' + ln(1 + x^2) x = 0", "x'' + log(1 + x^2)*x = 0"),
            ("x'' + Heaviside(x) x = 0", "x'' + H(x)*x = 0"),
            ("x'' + Sin(x) = 0", "x'' + sin(x) = 0"),
            ("x'' + sin^2(x) x = 0", "x'' + sin(x)^2*x = 0"),
            ("x'' + sin²(x)·x = 0", "x'' + sin(x)^2*x = 0"),
            ("x'' + √2 x + √(1+x²) = 0", "x'' + sqrt(2)*x + sqrt(1+x^2) = 0"),
            ("x'' + [x + {x}^3] = 0", "x'' + (x + (x)^3) = 0"),
            ("x'' + eps(x + x^3) = 0", "x'' + eps*(x + x^3) = 0"),
            ("x'' + x'(x^2 - 1) + x = 0", "x'' + x'*(x^2 - 1) + x = 0"),
            ("x'' + x(1 + x^2) = 0", "x'' + x*(1 + x^2) = 0"),
            ("x'' + c x' + k x = 0", "x'' + c*x' + k*x = 0"),
        ] {
            assert_eq!(equation_in_grammar(typed), read, "{typed}");
            assert!(parse_equation(read).is_ok(), "{read}");
        }
        for (typed, read) in [("60°", "60*pi/180"), ("90deg", "90*pi/180"), ("1.5rad", "1.5")] {
            assert_eq!(expression_in_grammar(typed), read, "{typed}");
        }
    }

    /// A text that may mean two things is an error as it stands.
    #[test]
    fn what_is_ambiguous_is_left_alone() {
        for typed in [
            "x'' + k(x) = 0",
            "x'' + f(x - 1) = 0",
            "x'' + k(t)*x = 0",
            "x'' + delta(t - 1) = 0",
            "x'' + sin⁻¹(x) = 0",
            "x'' + sin x cos x = 0",
            "x'' + sin 2 x = 0",
            "x'' + 2e = 0",
            "x'' + 0x10 = 0",
            "x'' + x 1 = 0",
            "x'' + ωn*x = 0",
            "x'' + 1½x = 0",
            "x'' + |x + |x|| = 0",
            "d x/dt + x = 0",
            "x'' + 1,5*x = 0",
            "x'' + sn(x) = 0",
        ] {
            assert_eq!(equation_in_grammar(typed), typed);
            assert!(parse_equation(typed).is_err(), "{typed}");
        }
    }

    /// Reading ends for every text.
    #[test]
    fn long_texts_are_not_corrected_without_end() {
        let text = format!("x''{}", " + 2x".repeat(3_000));
        assert_eq!(equation_in_grammar(&text), text);
        let text = format!("x''{}", " + 2x".repeat(400));
        assert!(parse_equation(&equation_in_grammar(&text)).is_ok());
    }
}

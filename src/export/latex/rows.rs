//! Rows of `align*` that fit a line of an article; long sums break before a sign.
//!
//! A row breaks outside of its brackets where it can. Where a bracket alone is longer than a line, it
//! breaks inside, and the bracket is set without `\left` and `\right`, which hold a line together.

/// The width of a line of an article, in characters of a formula.
const WIDTH: f64 = 57.0;

/// The rows of a formula, `left &= right`, a single one if it fits a line.
pub(in crate::export) fn rows(formula: &str) -> Vec<String> {
    /// The widest left side that leaves room for the right sides of other rows.
    const WIDEST_LEFT: f64 = 22.0;
    match formula.split_once(" &= ") {
        Some((left, right)) if width(left) > WIDEST_LEFT => rows(&format!("&{left} = {right}")),
        _ if width(formula) <= WIDTH => vec![formula.to_owned()],
        _ => broken(formula),
    }
}

fn broken(formula: &str) -> Vec<String> {
    let begins = ["&=", "&\\quad"].map(|mark| formula.find(mark).map(|place| place + mark.len()));
    let begin = begins.into_iter().flatten().next().unwrap_or(0);
    let outside = breaks(formula, begin, 0);
    let longest = pieces(formula, &outside).into_iter().map(width).fold(0.0, f64::max);
    // Brackets in formulas with words are short.
    match longest <= WIDTH || formula.contains("\\text{") {
        true => joined(&pieces(formula, &outside)),
        false => {
            let open = in_open_brackets(formula);
            let inside = breaks(&open, begin, 1);
            joined(&pieces(&open, &inside))
        }
    }
}

/// The pieces joined to rows that fit a line.
fn joined(pieces: &[&str]) -> Vec<String> {
    /// The indentation of a continuation row.
    const QUAD: f64 = 3.0;
    let mut rows: Vec<String> = Vec::new();
    let mut length = f64::INFINITY;
    for piece in pieces {
        let more = width(piece);
        match rows.last_mut() {
            Some(row) if length + more <= WIDTH => {
                row.push_str(piece);
                length += more;
            }
            None => {
                rows.push((*piece).to_owned());
                length = more;
            }
            Some(_) => {
                rows.push(format!("&\\quad {}", piece.trim_start()));
                length = QUAD + more;
            }
        }
    }
    rows
}

/// A formula cut at these places.
fn pieces<'a>(formula: &'a str, places: &[usize]) -> Vec<&'a str> {
    let begins = std::iter::once(0).chain(places.iter().copied());
    let ends = places.iter().copied().chain([formula.len()]);
    begins.zip(ends).map(|(begin, end)| &formula[begin..end]).collect()
}

/// The places of the signs between terms, behind `begin`, in brackets to this depth and in no
/// braces.
fn breaks(formula: &str, begin: usize, deepest: usize) -> Vec<usize> {
    let (mut braces, mut brackets) = (0_usize, 0_usize);
    let mut places = Vec::new();
    let mut has_term = false;
    for (place, letter) in formula.char_indices() {
        match letter {
            '{' => braces += 1,
            '}' => braces = braces.saturating_sub(1),
            '(' | '[' => brackets += 1,
            ')' | ']' => brackets = brackets.saturating_sub(1),
            ' ' if braces == 0
                && brackets <= deepest
                && place > begin
                && has_term
                && (formula[place..].starts_with(" + ") || formula[place..].starts_with(" - ")) =>
            {
                places.push(place)
            }
            _ => {}
        }
        has_term |= place > begin && letter != ' ';
    }
    places
}

/// The formula with outermost brackets inside which it may break: `\bigl(` for `\left(`.
fn in_open_brackets(formula: &str) -> String {
    let mut open = String::with_capacity(formula.len());
    let (mut depth, mut rest) = (0_usize, formula);
    while let Some(letter) = rest.chars().next() {
        if let Some(after) = rest.strip_prefix("\\left") {
            // `\leftarrow` is not a bracket.
            let is_bracket = after.starts_with(['(', '[']);
            open.push_str(if is_bracket && depth == 0 { "\\bigl" } else { "\\left" });
            depth += usize::from(is_bracket);
            rest = after;
        } else if let Some(after) = rest.strip_prefix("\\right") {
            let is_bracket = after.starts_with([')', ']']);
            depth = depth.saturating_sub(usize::from(is_bracket));
            open.push_str(if is_bracket && depth == 0 { "\\bigr" } else { "\\right" });
            rest = after;
        } else {
            open.push(letter);
            rest = &rest[letter.len_utf8()..];
        }
    }
    open
}

/// The approximate width of a formula in characters: a fraction as wide as its wider part, an
/// exponent or an index at two thirds.
pub(super) fn width(formula: &str) -> f64 {
    let mut letters = formula.chars().peekable();
    let mut widths: Vec<f64> = vec![0.0];
    // For each open brace: the factor of its content, and whether it is the numerator of a fraction.
    let mut braces: Vec<(f64, Option<f64>)> = Vec::new();
    let mut numerator: Option<f64> = None;
    let (mut factor, mut is_fraction) = (1.0, false);
    while let Some(letter) = letters.next() {
        let add = match letter {
            '\\' => {
                let mut name = String::new();
                while let Some(next) = letters.next_if(char::is_ascii_alphabetic) {
                    name.push(next);
                }
                match name.as_str() {
                    "frac" | "tfrac" | "dfrac" => {
                        is_fraction = true;
                        0.0
                    }
                    "left" | "right" | "bigl" | "bigr" | "text" | "operatorname" | "mathrm" => 0.0,
                    "sin" | "cos" | "tan" | "log" | "exp" | "sgn" => 3.5,
                    "" => {
                        letters.next();
                        0.5
                    }
                    _ => 1.2,
                }
            }
            '^' | '_' => {
                factor = 0.65;
                0.0
            }
            '{' => {
                braces.push((factor, is_fraction.then_some(0.0)));
                widths.push(0.0);
                if is_fraction {
                    numerator = Some(0.0);
                }
                (factor, is_fraction) = (1.0, false);
                0.0
            }
            '}' => {
                let inner = widths.pop().unwrap_or(0.0);
                let (scale, fraction) = braces.pop().unwrap_or((1.0, None));
                match (fraction, letters.peek()) {
                    // The denominator follows.
                    (Some(_), Some('{')) => {
                        letters.next();
                        braces.push((scale, None));
                        widths.push(0.0);
                        numerator = Some(inner);
                        0.0
                    }
                    _ => scale * inner.max(numerator.take().unwrap_or(0.0)),
                }
            }
            '&' | ' ' => 0.0,
            '+' | '-' | '=' | '<' | '>' => 2.0,
            '(' | ')' | ',' | '.' => 0.8,
            _ => 1.0,
        };
        if !matches!(letter, '^' | '_' | '{' | '\\') {
            if let Some(width) = widths.last_mut() {
                *width += add * if letter == '}' { 1.0 } else { factor };
            }
            factor = 1.0;
        } else if letter == '\\' {
            if let Some(width) = widths.last_mut() {
                *width += add * factor;
            }
            factor = 1.0;
        }
    }
    widths.into_iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_sums_become_rows_of_the_same_terms() {
        let term = |k: usize| format!("\\frac{{{k}}}{{1536}} A^{{{k}}}");
        let sum: Vec<String> = (1..30).map(term).collect();
        let formula = format!("\\omega^{{2}} &= 1 - {}", sum.join(" + "));
        let broken = rows(&formula);
        assert!(broken.len() > 2 && broken.iter().all(|row| width(row) <= WIDTH + 3.0));
        let words = |text: &str| {
            text.replace("&\\quad ", "").split_whitespace().collect::<Vec<_>>().join(" ")
        };
        assert_eq!(words(&broken.join(" ")), words(&formula));
        assert!(broken[1..].iter().all(|row| row.starts_with("&\\quad + ")));
        assert_eq!(rows("x &= 1 + y"), ["x &= 1 + y"]);
        // A row that goes on already stays one.
        assert!(broken.iter().all(|row| rows(row) == [row.clone()]));
        let left = format!("{} &= 0", ["\\ddot{x} \\cos x"; 5].join(" + "));
        assert_eq!(rows(&left), [format!("&{}", left.replace(" &=", " ="))]);
    }

    #[test]
    fn a_long_bracket_breaks_inside_and_is_set_open() {
        let sum = ["\\frac{17 A^{5}}{61440}"; 12].join(" + ");
        let broken = rows(&format!("x &= \\left({sum}\\right) \\cos \\theta"));
        assert!(broken.len() > 1, "{broken:?}");
        assert!(
            broken[0].contains("\\bigl(")
                && broken.last().is_some_and(|row| row.contains("\\bigr)"))
        );
        let long = "\\frac{a_{1} a_{2} a_{3} a_{4} a_{5} a_{6}}{2}";
        assert!((width(long) - width(&long.replace('2', "9"))).abs() < 1e-9);
        assert!(width(long) < width(&format!("{long} + {long}")) / 2.0 + 1.5);
    }
}

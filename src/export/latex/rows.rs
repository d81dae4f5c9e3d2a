//! Rows of `align*` that fit a line of an article; long sums break before a sign.
//!
//! A row breaks outside of its brackets where it can. Where a bracket alone is longer than a line, it
//! breaks inside, and the bracket is set without `\left` and `\right`, which hold a line together.

/// The width of a line of an article, in characters of a formula.
const WIDTH: f64 = 57.0;

/// The widest left side that leaves room for the right sides of other rows.
const WIDEST_LEFT: f64 = 22.0;

/// The rows of a formula, `left &= right`, a single one if it fits a line.
pub(in crate::export) fn rows(formula: &str) -> Vec<String> {
    let formula = with_left_at_most(WIDEST_LEFT, formula);
    rows_beside(width_of_left(&formula), &formula)
}

/// The rows of the formulas of one `align*`: the widest left side leaves less room for the right
/// sides of all others.
pub(in crate::export) fn aligned(formulas: &[String]) -> Vec<String> {
    /// The widest left side beside right sides that are long.
    const WIDEST_BESIDE_LONG: f64 = 12.0;
    let with_lefts = |most: f64| -> (Vec<String>, f64) {
        let formulas: Vec<String> =
            formulas.iter().map(|formula| with_left_at_most(most, formula)).collect();
        let widest = formulas.iter().map(|formula| width_of_left(formula)).fold(0.0, f64::max);
        (formulas, widest)
    };
    let (mut formulas, mut widest) = with_lefts(WIDEST_LEFT);
    let right = |formula: &String| width(formula) - width_of_left(formula);
    if formulas.iter().any(|formula| widest + right(formula) > WIDTH) {
        (formulas, widest) = with_lefts(WIDEST_BESIDE_LONG);
    }
    formulas.iter().flat_map(|formula| rows_beside(widest, formula)).collect()
}

/// The formula, with a left side that is wider than this moved into the row.
fn with_left_at_most(most: f64, formula: &str) -> String {
    match formula.split_once(" &= ") {
        Some((left, right)) if width(left) > most => format!("&{left} = {right}"),
        _ => formula.to_owned(),
    }
}

/// The width of what stands before the sign at which rows are aligned.
fn width_of_left(formula: &str) -> f64 {
    formula.split_once('&').map_or(0.0, |(left, _)| width(left))
}

/// The rows of a formula beside left sides of this width.
fn rows_beside(left: f64, formula: &str) -> Vec<String> {
    let room = WIDTH - left;
    match formula.strip_prefix("&\\text{").and_then(|rest| rest.strip_suffix('}')) {
        Some(words) if !words.replace("\\^{}", "").contains(['{', '}', '$']) => {
            lines_of_words(room, words)
        }
        _ if width(formula) - width_of_left(formula) <= room => vec![formula.to_owned()],
        _ => broken(room, formula),
    }
}

/// Words in rows of this width.
fn lines_of_words(room: f64, words: &str) -> Vec<String> {
    /// The width of a letter in words, beside one of a formula.
    const LETTER: f64 = 0.75;
    let mut lines: Vec<String> = Vec::new();
    let mut length = f64::INFINITY;
    for word in words.split(' ') {
        let more = LETTER * (word.chars().count() + 1) as f64;
        match lines.last_mut() {
            Some(line) if length + more <= room => {
                line.push(' ');
                line.push_str(word);
                length += more;
            }
            _ => {
                lines.push(word.to_owned());
                length = more;
            }
        }
    }
    lines.iter().map(|line| format!("&\\text{{{line}}}")).collect()
}

fn broken(room: f64, formula: &str) -> Vec<String> {
    let begins = ["&=", "&\\quad"].map(|mark| formula.find(mark).map(|place| place + mark.len()));
    let begin = begins.into_iter().flatten().next().unwrap_or(0);
    let outside = breaks(formula, begin, 0);
    let right = |piece: &str| width(piece) - width_of_left(piece);
    let longest = pieces(formula, &outside).into_iter().map(right).fold(0.0, f64::max);
    // Brackets in formulas with words are short.
    match longest <= room || formula.contains("\\text{") {
        true => joined(room, &pieces(formula, &outside)),
        false => {
            let open = in_open_brackets(formula);
            let inside = breaks(&open, begin, 1);
            joined(room, &pieces(&open, &inside))
        }
    }
}

/// The pieces joined to rows whose right sides have this width.
fn joined(room: f64, pieces: &[&str]) -> Vec<String> {
    /// The indentation of a continuation row.
    const QUAD: f64 = 3.0;
    let mut rows: Vec<String> = Vec::new();
    let mut length = f64::INFINITY;
    for piece in pieces {
        let more = width(piece);
        match rows.last_mut() {
            Some(row) if length + more <= room => {
                row.push_str(piece);
                length += more;
            }
            None => {
                rows.push((*piece).to_owned());
                length = more - width_of_left(piece);
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

/// The signs before which a row may break: of a term, of a consequence, and before another equation.
const SIGNS: [&str; 4] = [" + ", " - ", " \\quad\\Rightarrow", " \\qquad "];

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
                && SIGNS.iter().any(|sign| formula[place..].starts_with(sign)) =>
            {
                places.push(place)
            }
            _ => {}
        }
        has_term |= place > begin && letter != ' ';
    }
    places
}

/// The width of the longest part of a formula that a line of words does not break.
pub(super) fn longest_term(formula: &str) -> f64 {
    let open = in_open_brackets(formula);
    let places = breaks(&open, 0, 1);
    pieces(&open, &places).into_iter().map(width).fold(0.0, f64::max)
}

/// The formula with `(a)/b` for each outermost fraction that is wider than this.
pub(super) fn with_solidus(formula: &str, widest: f64) -> String {
    const FRACTION: &str = "\\frac{";
    let (mut text, mut rest, mut braces) = (String::with_capacity(formula.len()), formula, 0_usize);
    while let Some(letter) = rest.chars().next() {
        let fraction = rest.strip_prefix(FRACTION).filter(|_| braces == 0);
        let parts = fraction.and_then(|inside| {
            let (numerator, after) = split_at_brace(inside)?;
            let (denominator, after) = split_at_brace(after.strip_prefix('{')?)?;
            Some((numerator, denominator, after))
        });
        match parts {
            Some((numerator, denominator, after))
                if width(&rest[..rest.len() - after.len()]) > widest =>
            {
                let is_number = denominator.chars().all(|letter| letter.is_ascii_digit());
                let [open, close] = if is_number { ["", ""] } else { ["\\left(", "\\right)"] };
                text.push_str(&format!("\\bigl({numerator}\\bigr)/{open}{denominator}{close}"));
                rest = after;
            }
            _ => {
                match letter {
                    '{' => braces += 1,
                    '}' => braces = braces.saturating_sub(1),
                    _ => {}
                }
                text.push(letter);
                rest = &rest[letter.len_utf8()..];
            }
        }
    }
    text
}

/// The content of braces that are open, and what follows them.
fn split_at_brace(text: &str) -> Option<(&str, &str)> {
    let mut depth = 0_usize;
    for (place, letter) in text.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' if depth == 0 => return Some((&text[..place], &text[place + 1..])),
            '}' => depth -= 1,
            _ => {}
        }
    }
    None
}

/// The formula with outermost brackets inside which it may break: `\bigl(` for `\left(`.
pub(super) fn in_open_brackets(formula: &str) -> String {
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

/// The content of a pair of braces.
enum Braces {
    /// Anything but a part of a fraction.
    Plain,
    /// The numerator of a fraction.
    Numerator,
    /// The denominator of a fraction whose numerator has this width.
    Denominator(f64),
}

/// The approximate width of a formula in characters: a fraction as wide as its wider part, an
/// exponent or an index at two thirds.
pub(super) fn width(formula: &str) -> f64 {
    /// The gaps on both sides of a fraction.
    const GAPS: f64 = 0.4;
    let mut letters = formula.chars().peekable();
    let mut widths: Vec<f64> = vec![0.0];
    // For each open brace: the factor of its content, and its part in a fraction.
    let mut braces: Vec<(f64, Braces)> = Vec::new();
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
                braces.push((factor, if is_fraction { Braces::Numerator } else { Braces::Plain }));
                widths.push(0.0);
                (factor, is_fraction) = (1.0, false);
                0.0
            }
            '}' => {
                let inner = widths.pop().unwrap_or(0.0);
                let (scale, part) = braces.pop().unwrap_or((1.0, Braces::Plain));
                match (part, letters.peek()) {
                    (Braces::Numerator, Some('{')) => {
                        letters.next();
                        braces.push((scale, Braces::Denominator(inner)));
                        widths.push(0.0);
                        0.0
                    }
                    (Braces::Denominator(numerator), _) => scale * (inner.max(numerator) + GAPS),
                    _ => scale * inner,
                }
            }
            '&' | ' ' => 0.0,
            '+' | '-' | '=' | '<' | '>' => 2.0,
            '(' | ')' | ',' | '.' => 0.8,
            'A'..='Z' => 1.25,
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
    fn a_wide_left_side_leaves_less_room_to_all_rows() {
        let sum = ["\\frac{17 A^{5}}{61440}"; 9].join(" + ");
        let formulas = ["\\ddot{x} + x + y &= 0".to_owned(), format!("x &= {sum}")];
        let room = |rows: &[String]| rows.iter().map(|row| width(row)).fold(0.0, f64::max);
        let together = aligned(&formulas);
        assert!(room(&together[1..]) <= WIDTH - width("\\ddot{x} + x + y") + 3.0, "{together:?}");
        // A very wide one becomes a part of its row.
        let wide = format!("{} &= 0", ["\\ddot{x} x"; 6].join(" + "));
        assert!(aligned(&[wide, formulas[1].clone()])[0].starts_with("&\\ddot"));
        let words = ["long words of a derivation"; 5].join(" ");
        let lines = aligned(&[format!("&\\text{{{words}}}")]);
        assert!(lines.len() > 1 && lines.iter().all(|line| line.starts_with("&\\text{")));
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
        let fraction = "x + \\frac{a + \\sqrt{b}}{3 c} - \\frac{1}{2}";
        assert_eq!(
            with_solidus(fraction, 5.0),
            "x + \\bigl(a + \\sqrt{b}\\bigr)/\\left(3 c\\right) - \\frac{1}{2}"
        );
        let long = "\\frac{a_{1} a_{2} a_{3} a_{4} a_{5} a_{6}}{2}";
        assert!((width(long) - width(&long.replace('2', "9"))).abs() < 1e-9);
        assert!(width(long) < width(&format!("{long} + {long}")) / 2.0 + 1.5);
    }
}

//! Formulas from LaTeX to MathML Core.

use math_core::{LatexToMathML, MathCoreConfig, MathDisplay};

use super::escaped;

/// Converts formulas from LaTeX to MathML.
pub(super) struct Typesetter(Option<LatexToMathML>);

impl Default for Typesetter {
    fn default() -> Self {
        Self(LatexToMathML::new(MathCoreConfig::default()).ok())
    }
}

impl Typesetter {
    /// Rows of `align*`, one below the other.
    pub(super) fn display(&self, rows: &[String]) -> String {
        let together = format!("\\begin{{aligned}}\n{}\n\\end{{aligned}}", rows.join(" \\\\\n"));
        let set = self
            .set(&together, MathDisplay::Block)
            .unwrap_or_else(|| rows.iter().map(|row| unset(row) + "<br>\n").collect());
        format!("<div class=\"math\">{set}</div>\n")
    }

    /// A formula in a line.
    pub(super) fn inline(&self, formula: &str) -> String {
        self.set(formula, MathDisplay::Inline).unwrap_or_else(|| unset(formula))
    }

    /// LaTeX of running text with formulas between dollars.
    pub(super) fn mixed(&self, text: &str) -> String {
        let mut html = String::new();
        for (place, piece) in pieces(text).into_iter().enumerate() {
            html += &match (place % 2, number(&piece)) {
                (0, _) => escaped(&piece),
                (_, Some(number)) => number,
                (_, None) => self.inline(&piece),
            };
        }
        html
    }

    fn set(&self, formula: &str, display: MathDisplay) -> Option<String> {
        let formula = words_apart(formula);
        let set = self.0.as_ref()?.convert_with_local_counter(&formula, display).ok()?;
        // Set as indices, primes are shrunk once more in fonts that have them small already; the
        // class marks them for the style sheet.
        Some(["\u{2032}", "\u{2033}", "\u{2034}"].iter().fold(set, |set, primes| {
            set.replace(
                &format!("<mo>{primes}</mo>"),
                &format!("<mo class=\"primes\">{primes}</mo>"),
            )
        }))
    }
}

/// A formula whose words hold no formulas: `\text{no $a$ in $b$}` becomes
/// `\text{no }a\text{ in }b`.
fn words_apart(formula: &str) -> String {
    let mut apart = String::with_capacity(formula.len());
    let (mut inside, mut before) = (false, ' ');
    for letter in formula.chars() {
        match letter {
            '$' if before != '\\' => {
                apart.push_str(if inside { "\\text{" } else { "}" });
                inside = !inside;
            }
            _ => apart.push(letter),
        }
        before = letter;
    }
    apart
}

/// A formula that cannot be converted, as its LaTeX text.
fn unset(formula: &str) -> String {
    format!("<code>{}</code>", escaped(formula))
}

/// Words and formulas in turn, the words as plain text.
fn pieces(text: &str) -> Vec<String> {
    let mut pieces = vec![String::new()];
    let mut letters = text.chars().peekable();
    let mut before = ' ';
    while let Some(letter) = letters.next() {
        let in_words = pieces.len() % 2 == 1;
        // A dash between two names, or for an empty cell; an option keeps its hyphens.
        let dash = text == "--" || before.is_alphabetic();
        before = letter;
        let piece = match letter {
            '$' => {
                pieces.push(String::new());
                continue;
            }
            // A hat is followed by braces.
            '\\' if in_words => match letters.next() {
                Some('^') => {
                    letters.next_if_eq(&'{');
                    letters.next_if_eq(&'}');
                    "^".to_owned()
                }
                Some(letter) => letter.to_string(),
                None => String::new(),
            },
            '-' if in_words && dash && letters.next_if_eq(&'-').is_some() => "\u{2013}".to_owned(),
            letter => letter.to_string(),
        };
        if let Some(last) = pieces.last_mut() {
            last.push_str(&piece);
        }
    }
    pieces
}

/// A number, or a sign alone, that needs no formula: it can be copied as it is printed by every
/// other format.
fn number(formula: &str) -> Option<String> {
    if let "<" | ">" = formula {
        return Some(escaped(formula));
    }
    let formula = formula.replace("\\,\\%", " %");
    let (mantissa, exponent) = match formula.split_once(" \\cdot 10^{") {
        None => (formula.as_str(), None),
        Some((mantissa, rest)) => (mantissa, Some(rest.split_once('}')?)),
    };
    let unit = exponent.map_or("", |(_, unit)| unit);
    let digits = mantissa.strip_suffix(" %").unwrap_or(mantissa);
    digits.parse::<f64>().ok()?;
    Some(match exponent {
        None => mantissa.to_owned(),
        Some((exponent, _)) => format!("{mantissa}e{exponent}{unit}"),
    })
}

//! The terms of an equation as they were typed, so that messages quote what the user wrote and not
//! a normal form.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use super::parse::excerpt;
use super::{Expr, ExprError};
use crate::symbol::Symbol;

/// The text of an equation and the terms of its two sides.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Typed {
    text: String,
    terms: Vec<TypedTerm>,
}

/// One term of either side, or of a bracket there that is scaled by numbers and parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct TypedTerm {
    /// The value that the term adds to its own side.
    pub value: Expr,
    /// Its range in the text, without the sign.
    pub span: Range<usize>,
    /// Whether a minus stands before it.
    pub negative: bool,
    /// Whether it stands right of the equals sign.
    pub right: bool,
    /// The context of the bracket around it; `None` outside of brackets.
    pub around: Option<Arc<BracketContext>>,
}

/// The context of a bracket: in `-2*(x + x^2)/3` it is the texts `2*(` and `)/3`, and the minus. A
/// bracket without a factor leaves the texts empty. The context of a nested bracket includes that
/// of the bracket around it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BracketContext {
    pub opening: String,
    pub closing: String,
    /// Whether the signs before the brackets, except those inside the texts, amount to a minus.
    pub negative: bool,
    /// The factor of the terms inside, signs included.
    pub scale: Expr,
}

/// A part of an equation that an error message names: the expression, and the words for it, which
/// are as typed once the term that it comes from is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quotation {
    expression: Expr,
    words: String,
}

impl Quotation {
    /// An expression with the words that quote it.
    ///
    /// ```
    /// # use lindstedt_expr as lindstedt;
    /// use lindstedt::expr::{Quotation, parse_expression};
    ///
    /// let damping = parse_expression("0.5*x'")?;
    /// assert_eq!(Quotation::from(damping.clone()).to_string(), "x'/2");
    /// assert_eq!(Quotation::new(damping, "0.5*x'".to_owned()).to_string(), "0.5*x'");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(expression: Expr, words: String) -> Self {
        Self { expression, words }
    }

    /// The named expression.
    pub fn expression(&self) -> &Expr {
        &self.expression
    }

    /// The words for it.
    pub fn words(&self) -> &str {
        &self.words
    }
}

/// A quotation in the words of the normal form.
impl From<Expr> for Quotation {
    fn from(expression: Expr) -> Self {
        let words = expression.to_string();
        Self { expression, words }
    }
}

impl fmt::Display for Quotation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.words)
    }
}

impl Typed {
    pub(super) fn new(text: &str, terms: Vec<TypedTerm>) -> Self {
        Self { text: text.to_owned(), terms }
    }

    /// The contribution of each term to the left side, in the order of the text.
    pub fn values(&self) -> impl Iterator<Item = Expr> {
        self.terms.iter().map(|term| match term.right {
            true => -&term.value,
            false => term.value.clone(),
        })
    }

    /// Returns the terms with values for some of their parameters; the text stays the same.
    ///
    /// # Errors
    /// [`ExprError`] if a term is undefined at these values.
    pub fn with_values(&self, values: &BTreeMap<Symbol, Expr>) -> Result<Self, ExprError> {
        let mut typed = self.clone();
        for term in &mut typed.terms {
            term.value = term.value.substitute_all(values)?;
        }
        Ok(typed)
    }

    /// Quotes the terms with these indices as one text: `0.5*(x')^3`. A single term keeps the sign
    /// that it was typed with; of several terms, those of the right side are brought to the left.
    /// The scale of the brackets is written if the terms come from different brackets, or are all
    /// mere numbers.
    pub fn quote(&self, numbers: &[usize]) -> String {
        /// The longest text that a message quotes in full.
        const LONGEST: usize = 120;
        let terms: Vec<&TypedTerm> =
            numbers.iter().filter_map(|&number| self.terms.get(number)).collect();
        let is_number =
            |term: &&TypedTerm| !self.text[term.span.clone()].contains(char::is_alphabetic);
        let scaled =
            terms.iter().any(|term| term.around != terms[0].around) || terms.iter().all(is_number);
        let mut quote = String::new();
        for term in &terms {
            let around = term.around.as_ref().filter(|_| scaled);
            let turned = around.is_some_and(|around| around.negative);
            let minus = term.negative ^ turned ^ (term.right && terms.len() > 1);
            quote.push_str(match (quote.is_empty(), minus) {
                (true, false) => "",
                (true, true) => "-",
                (false, false) => " + ",
                (false, true) => " - ",
            });
            let words: Vec<&str> = self.text[term.span.clone()].split_whitespace().collect();
            quote.push_str(around.map_or("", |around| &around.opening));
            quote.push_str(&words.join(" "));
            quote.push_str(around.map_or("", |around| &around.closing));
        }
        match quote.char_indices().nth(LONGEST) {
            Some((cut, _)) => format!("{}...", &quote[..cut]),
            None => quote,
        }
    }

    /// Returns the line in which a quotation stands, and a line with carets under it; `None` if the
    /// quotation does not occur literally.
    pub fn locate(&self, quotation: &str) -> Option<[String; 2]> {
        let number = (0..self.terms.len()).find(|&number| self.quote(&[number]) == quotation);
        let span = match number.and_then(|number| self.terms.get(number)) {
            Some(term) => term.span.clone(),
            None => span_of(&self.text, quotation)?,
        };
        Some(excerpt(&self.text, &span))
    }

    /// Whether a text occurs literally in the equation.
    pub fn contains(&self, quotation: &str) -> bool {
        span_of(&self.text, quotation).is_some()
    }
}

/// Returns the line of a text in which a quotation stands literally, not as a part of a longer name,
/// and a line with carets under it; `None` if it does not occur.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// let [line, carets] = lindstedt::expr::excerpt_of("x'' + x' + x = 0", "x'").ok_or("no x'")?;
/// assert_eq!((line.as_str(), carets.as_str()), ("x'' + x' + x = 0", "      ^^"));
/// # Ok::<(), &str>(())
/// ```
pub fn excerpt_of(text: &str, quotation: &str) -> Option<[String; 2]> {
    span_of(text, quotation).map(|span| excerpt(text, &span))
}

/// Returns the range of a quotation that is not part of a longer name; `None` if it does not occur.
fn span_of(text: &str, quotation: &str) -> Option<Range<usize>> {
    let in_name = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == '\'';
    let spans = text.match_indices(quotation);
    let mut spans = spans.map(|(start, found)| start..start + found.len());
    spans.find(|span| {
        let before = text[..span.start].chars().next_back();
        let after = text[span.end..].chars().next();
        !quotation.is_empty() && !before.is_some_and(in_name) && !after.is_some_and(in_name)
    })
}

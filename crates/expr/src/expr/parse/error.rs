//! The syntax error, shown below the line of the text.

use std::fmt;
use std::ops::Range;

use super::lexer::printable;

/// A syntax error: the message, the position, and the text to write instead.
///
/// `Display` shows the line with a caret under the place:
///
/// ```text
/// `2x`: a product needs its sign
///   x'' + 2x = 0
///         ^^ try `2*x`
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParseError {
    /// The error in one line.
    pub message: String,
    /// The range of the error in the text, in bytes.
    pub span: Range<usize>,
    /// Advice on what to write instead; `None` if there is none.
    pub help: Option<String>,
    /// The part of the text that has only one possible meaning, and its spelling in the grammar;
    /// `None` if it is ambiguous.
    pub(super) correction: Option<Box<(Range<usize>, String)>>,
    /// The line of the text, cut to what fits, and a line with carets.
    excerpt: Box<[String; 2]>,
}

impl fmt::Display for ParseError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [line, carets] = &*self.excerpt;
        write!(formatter, "{}", self.message)?;
        match (line.trim().is_empty(), &self.help) {
            (true, None) => Ok(()),
            (true, Some(help)) => write!(formatter, "\n  {help}"),
            (false, None) => write!(formatter, "\n  {line}\n  {carets}"),
            (false, Some(help)) => write!(formatter, "\n  {line}\n  {carets} {help}"),
        }
    }
}

impl std::error::Error for ParseError {}

impl ParseError {
    pub(super) fn new(text: &str, span: Range<usize>, message: &str, help: &str) -> Self {
        let excerpt = Box::new(excerpt(text, &span));
        let help = (!help.is_empty()).then(|| help.to_string());
        Self { message: message.to_string(), span, help, correction: None, excerpt }
    }

    /// Returns the error of a part of a text, which begins at this byte of it, as one of the whole.
    pub(super) fn within(self, whole: &str, first: usize) -> Self {
        let shifted = |range: Range<usize>| range.start + first..range.end + first;
        let span = shifted(self.span);
        let excerpt = Box::new(excerpt(whole, &span));
        let correction = self.correction.map(|inner| Box::new((shifted(inner.0), inner.1)));
        Self { span, excerpt, correction, ..self }
    }

    /// Returns the error with a correction: this part of the text can only mean `replacement`.
    pub(super) fn meaning(self, part: Range<usize>, replacement: impl Into<String>) -> Self {
        Self { correction: Some(Box::new((part, replacement.into()))), ..self }
    }

    /// Returns the error with a correction of the shown place, if there is a `replacement`.
    pub(super) fn meaning_here(self, replacement: Option<String>) -> Self {
        let place = self.span.clone();
        match replacement {
            Some(replacement) => self.meaning(place, replacement),
            None => self,
        }
    }
}

/// Returns the line around the place, at most about a hundred characters of it, and a line of
/// carets below.
pub fn excerpt(text: &str, span: &Range<usize>) -> [String; 2] {
    const WIDTH: usize = 100;
    let start = text[..span.start].rfind(['\n', '\r', '\u{feff}']);
    let start =
        start.map_or(0, |place| place + text[place..].chars().next().map_or(0, char::len_utf8));
    let end =
        text[span.start..].find(['\n', '\r']).map_or(text.len(), |length| span.start + length);
    let line = &text[start..end];
    let column = text[start..span.start].chars().count();
    let length = text[span.start..span.end.min(end).max(span.start)].chars().count().max(1);
    // The place stands in the first third of a window that is cut on both sides.
    let skipped = if column > WIDTH * 2 / 3 { column - WIDTH / 3 } else { 0 };
    let shown: String = line.chars().skip(skipped).take(WIDTH).map(printable).collect();
    let cut = line.chars().nth(skipped + WIDTH).is_some();
    let (before, after) = (if skipped > 0 { "..." } else { "" }, if cut { "..." } else { "" });
    let indent = before.len() + column - skipped;
    let carets = length.min(WIDTH.saturating_sub(column - skipped).max(1));
    [format!("{before}{shown}{after}"), format!("{}{}", " ".repeat(indent), "^".repeat(carets))]
}

/// Returns the text, cut off to fit into a message.
pub(super) fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    match text.char_indices().nth(LONGEST) {
        None => text.chars().map(printable).collect(),
        Some((cut, _)) => text[..cut].chars().map(printable).chain("...".chars()).collect(),
    }
}

//! A result in the format that was asked for: what every command has in common once its work is
//! done.

use std::path::PathBuf;

use crate::export::html::{self, HtmlPage};
use crate::export::{latex, printable, text};
use crate::report::Document;
use crate::solution::Solution;

use super::{Common, Failure, Format, Outcome, Reason, session, text_writer};

/// A result, and how it is written in each format.
pub(super) struct Answer<'a> {
    /// The answer.
    pub(super) document: &'a Document<'a>,
    /// The largest width of a line of text, in characters.
    pub(super) width: usize,
    /// Its picture, drawn when it is asked for; `None` if a kind of result has none.
    pub(super) picture: Option<Draw<'a>>,
    /// Writes the formats that are not made of a document: JSON, comma-separated values, programs.
    pub(super) other: &'a dyn Fn(Format) -> Result<String, Failure>,
}

/// Draws a picture, or says why there is none.
pub(super) type Draw<'a> = &'a dyn Fn() -> Result<String, Failure>;

impl Answer<'_> {
    /// The result and the picture that were asked for, without a verdict.
    pub(super) fn outcome(&self, common: &Common) -> Result<Outcome, Failure> {
        let text = self.written(common, common.format())?;
        let session = session::current();
        session.keep_forms(common.format(), |format| self.written(common, format));
        Ok(Outcome {
            result: text_writer(text),
            picture: pictured(common, self.picture),
            note: None,
            verdict: None,
            partial: false,
        })
    }

    /// The result in a format.
    fn written(&self, common: &Common, format: Format) -> Result<String, Failure> {
        Ok(match format {
            Format::Text => printable(&text::document(self.document, self.width)),
            Format::Latex => common.latex(printable(&latex::document(self.document))),
            Format::Html => {
                printable(&page(self.picture, None, |page| html::document(self.document, page)))
            }
            Format::Svg => drawn(self.picture)?,
            format => (self.other)(format)?,
        })
    }
}

/// The picture of `--plot` and its place, where there is one.
pub(super) fn pictured(
    common: &Common,
    picture: Option<Draw>,
) -> Option<(PathBuf, Result<String, Failure>)> {
    Some((common.plot.clone()?, picture?()))
}

/// The picture as the result.
pub(super) fn drawn(picture: Option<Draw>) -> Result<String, Failure> {
    match picture {
        Some(draw) => draw(),
        None => no_such(Format::Svg),
    }
}

/// The page that `write` makes, with its picture and the command that made it. A page without a
/// picture says why there is none.
pub(super) fn page(
    picture: Option<Draw>,
    derivation: Option<(&Solution, bool)>,
    write: impl FnOnce(&HtmlPage) -> String,
) -> String {
    let drawn = picture.map(|draw| {
        draw().map_err(|failure| match failure {
            Failure::Refused(Reason { text, .. }) | Failure::Usage(text) => text,
        })
    });
    let picture = drawn.as_ref().map(|drawn| match drawn {
        Ok(picture) => Ok(picture.as_str()),
        Err(reason) => Err(reason.as_str()),
    });
    let session = session::current();
    // Inside another process the format is the caller's, not the user's.
    let words = match session.is_call() {
        true => what_is_asked(&session.words()),
        false => session.words(),
    };
    write(&HtmlPage {
        title: &command_text(&what_is_asked(&words)),
        picture,
        derivation,
        made_by: &command_text(&words),
    })
}

/// The words of a command without those that say how its result is handed on.
fn what_is_asked(words: &[String]) -> Vec<String> {
    const HANDED_ON: [&str; 4] = ["--format", "--output", "-o", "--plot"];
    const ABOUT_THE_REST: [&str; 3] = ["--quiet", "-q", "--standalone"];
    let mut asked = Vec::new();
    let mut words = words.iter();
    while let Some(word) = words.next() {
        let option = word.split_once('=').map_or(word.as_str(), |(option, _)| option);
        if ABOUT_THE_REST.contains(&word.as_str()) {
            continue;
        } else if !HANDED_ON.contains(&option) {
            asked.push(word.clone());
        } else if option == word {
            words.next();
        }
    }
    asked
}

/// A command as it can be typed again.
pub(super) fn command_text(words: &[String]) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./=:,+".contains(letter);
    let quoted = |word: &String| match !word.is_empty() && word.chars().all(plain) {
        true => word.clone(),
        false => format!("\"{}\"", word.replace('\\', "\\\\").replace('"', "\\\"")),
    };
    std::iter::once("lindstedt".to_owned())
        .chain(words.iter().map(quoted))
        .collect::<Vec<_>>()
        .join(" ")
}

/// Refuses a format that a kind of result does not have.
pub(super) fn no_such<T>(format: Format) -> Result<T, Failure> {
    let (what, has_it) = match format {
        Format::Csv => (
            "table of comma-separated values",
            "`lindstedt compare`, `simulate`, `response`, `stability`, `absorber`, `orbits`, `shortest`, `fit`, `friction`, `materials` or `optimize`",
        ),
        Format::Toml => ("problem file", "`lindstedt fit`"),
        Format::Code(_) => ("program", "`lindstedt derive`"),
        Format::Svg => (
            "picture",
            "`lindstedt derive`, `compare`, `impact`, `simulate`, `response`, `stability`, `absorber`, `orbits`, `shortest`, `fit`, `friction`, `materials` or `optimize`",
        ),
        Format::Text | Format::Latex | Format::Json | Format::Html => {
            ("result in this format", "other commands")
        }
    };
    Err(Failure::Usage(format!(
        "there is no {what} here: --format {} belongs to {has_it}",
        format.name()
    )))
}

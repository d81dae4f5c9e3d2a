//! Errors of a TOML file, in words that need no Rust.
//!
//! In: the error of the parser, which serde reduces to a message and a position. Out: the same
//! error in the words of a problem file. Only this module reads the text of the message; those of
//! every kind of mistake are pinned by the tests below, and a message of another form is shown as
//! it stands.

use std::ops::Range;

use super::ProblemError;
use crate::expr::excerpt;
use crate::spelling::nearest;

/// The message of the parser in plain words, with its position shown as in every other message.
pub(crate) fn in_words(text: &str, error: &toml::de::Error) -> ProblemError {
    let said = error.message();
    // The first line of a message states the error; the others are details of the parser.
    let what = said.lines().next().unwrap_or_default();
    let what = match mismatch(what) {
        Some(message) => message,
        None if what.starts_with("invalid basic string, expected `\"`") => {
            "the text in quotes does not end".to_owned()
        }
        None if what.starts_with("cannot recurse") => "nested too deep".to_owned(),
        None => what.replacen("unknown field ", "unknown key ", 1),
    };
    let readable = |span: &Range<usize>| text.get(span.clone()).is_some();
    let error = match error.span().filter(readable) {
        None => ProblemError::new(what),
        Some(span) => at_place(text, &span, &what),
    };
    error.with_help(did_you_mean(said))
}

/// The error at a position of a text, which is shown with its line and a caret below.
pub(crate) fn at_place(text: &str, span: &Range<usize>, what: &str) -> ProblemError {
    let line = text[..span.start].matches('\n').count() + 1;
    let [shown, carets] = excerpt(text, span);
    ProblemError::new(format!("line {line}: {what}\n  {shown}\n  {carets}"))
}

/// "invalid type: string "big", expected f64" in words.
fn mismatch(message: &str) -> Option<String> {
    let rest = message
        .strip_prefix("invalid type: ")
        .or_else(|| message.strip_prefix("invalid value: "))?;
    let (found, expected) = rest.split_once(", expected ")?;
    let expected = match expected {
        "f64" => "a number",
        "u32" | "u64" | "usize" => "a whole number, 0 or more",
        "a string" => "text in quotes",
        other if other.starts_with("struct ") || other == "a map" => "a section in brackets",
        other => other,
    };
    let found = match found.split_once(' ') {
        Some(("string", _)) => "text",
        None if found == "map" => "a section",
        None if found == "sequence" => "a list",
        // integer `3`, floating point `2.5`, boolean `true`
        _ => found.split('`').nth(1).unwrap_or(found),
    };
    Some(format!("expected {expected}, not {found}"))
}

/// The nearest of the keys that "unknown field `a`, expected one of `b`, `c`" lists.
fn did_you_mean(message: &str) -> Option<String> {
    let names: Vec<&str> =
        message.strip_prefix("unknown field ")?.split('`').skip(1).step_by(2).collect();
    let (typed, known) = names.split_first()?;
    nearest(typed, known.iter().copied()).map(|name| format!("did you mean `{name}`?"))
}

#[cfg(test)]
mod tests {
    use crate::problem::Problem;

    #[test]
    fn mistakes_are_told_without_the_names_of_types() {
        let deep = format!("a = {}", "[".repeat(50_000));
        for (text, expected) in [
            ("[pendulum]\namplitude = \"big\"", "line 2: expected a number, not text"),
            ("equation = 3", "line 1: expected text in quotes, not 3"),
            ("[run]\nstep_limit = -3", "line 2: expected a whole number, 0 or more, not -3"),
            ("[run]\nstep_limit = 2.5", "line 2: expected a whole number, 0 or more, not 2.5"),
            ("pendulum = 3", "line 1: expected a section in brackets, not 3"),
            ("[pendulum]\namplitude = []", "line 2: expected a number, not a list"),
            ("[pendulum]\namplitude = true", "line 2: expected a number, not true"),
            (&deep, "line 1: nested too deep"),
        ] {
            let error = text.parse::<Problem>().expect_err("a mistake").to_string();
            assert!(error.starts_with(expected), "{error}");
            assert!(error.len() < 400 && error.ends_with('^'), "{error}");
        }
    }
}

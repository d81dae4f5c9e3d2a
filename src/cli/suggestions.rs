//! Options of other names: what is meant by `--x0 1`, `--A 1` or `--tend 10`.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::{COMMANDS, USUAL, session};

/// The error of the command line with the option that is meant, where an unknown one is given.
pub(super) fn with_what_is_meant(mut error: clap::Error) -> clap::Error {
    let Some(ContextValue::String(typed)) = error.get(ContextKind::InvalidArg) else {
        return error;
    };
    if error.kind() != ErrorKind::UnknownArgument {
        return error;
    }
    let words = session::current().words();
    let is_similar = matches!(error.get(ContextKind::SuggestedArg), Some(ContextValue::String(_)));
    if let Some(tip) = meant(typed, &words, is_similar) {
        error.remove(ContextKind::SuggestedArg);
        let tip = ContextValue::StyledStrs(vec![StyledStr::from(tip)]);
        error.insert(ContextKind::Suggested, tip);
    }
    error
}

/// What is meant by an option that there is not, among the words of a command line; `is_similar`
/// tells that the name of another option is like it.
fn meant(typed: &str, words: &[String], is_similar: bool) -> Option<String> {
    let named = |word: &String| COMMANDS.iter().find(|command| command.name == word.as_str());
    let command = words.iter().find_map(named);
    let command = command.or_else(|| COMMANDS.iter().find(|command| command.name == USUAL))?;
    let parser = command.parser();
    let takes = |long: &str| parser.get_arguments().any(|option| option.get_long() == Some(long));
    let (option, value) = match typed.split_once('=') {
        Some((option, value)) => (option, Some(value)),
        None => {
            let joined = |word: &String| {
                word.strip_prefix(typed)
                    .is_some_and(|rest| rest.is_empty() || rest.starts_with('='))
            };
            let place = words.iter().position(joined)?;
            let next = || words.get(place + 1).filter(|word| !word.starts_with("--"));
            let value = words[place].split_once('=').map(|(_, value)| value);
            (typed, value.or_else(|| next().map(String::as_str)))
        }
    };
    let name = option.trim_start_matches('-');
    let value = value.unwrap_or("VALUE");
    let tip = |long: &str, rest: String| takes(long).then(|| format!("try `--{long} {rest}`"));
    let is_name = name.starts_with(|letter: char| letter.is_alphabetic())
        && name.chars().all(|letter| letter.is_alphanumeric() || letter == '_');
    match name {
        "x0" | "x" => tip("from", format!("x={value}")),
        "v0" | "v" => tip("from", format!("x=0,v={value}")),
        "t" | "T" | "tend" | "t_end" | "t-end" | "tmax" | "time" | "duration" => {
            tip("until", value.to_owned())
        }
        "out" | "file" | "save" => tip("output", value.to_owned()),
        "pdf" | "png" => {
            Some("write a page with `-o FILE.html`, or a picture with `-o FILE.svg`".into())
        }
        "tex" | "latex" | "json" | "csv" | "svg" | "html" => tip("format", name.to_owned()),
        "n" | "N" | "degree" | "harmonics" | "terms" => tip("order", value.to_owned()),
        "param" | "params" | "values" | "set" | "value" => tip("at", "NAME=VALUE".to_owned()),
        "range" | "over" => tip("vary", "NAME=FROM:TO".to_owned()),
        _ if is_name && !is_similar => tip("at", format!("{name}={value}")),
        _ => None,
    }
}

//! Why a command ends without its result, in the words of the command line.

use std::fmt::Display;

use super::session;
use crate::Symbol;
use crate::solution::{Advice, Setting};

/// Why a command ends without its result.
pub(super) enum Failure {
    /// Exit code 1: the problem was refused, or something failed.
    Refused(Reason),
    /// Exit code 2.
    Usage(String),
}

/// The reason of a refusal.
#[derive(Debug, PartialEq)]
pub(super) struct Reason {
    /// The whole message, with its help and its notes.
    pub(super) text: String,
    /// The part of the program that refused, by the name of its error, `oscillator` say; `command`
    /// for what belongs to no part.
    pub(super) kind: String,
    /// The term of the equation that is to blame, as it was typed.
    pub(super) term: Option<String>,
}

/// A refusal that knows no way forward.
impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::refused(&error, None)
    }
}

impl Failure {
    /// A refusal with its way forward.
    pub(super) fn refused(error: &impl Display, help: Option<String>) -> Self {
        let text = match help {
            Some(help) => format!("{error}\n  help: {help}"),
            None => error.to_string(),
        };
        Self::Refused(Reason { text, kind: kind_of(error), term: None })
    }

    /// A refusal for this reason, by the command itself.
    pub(super) fn because(text: impl Into<String>) -> Self {
        Self::refused(&text.into(), None)
    }

    /// A refusal by the part of the program that this error belongs to.
    pub(super) fn of_kind<E>(self, error: &E) -> Self {
        match self {
            Self::Refused(reason) => Self::Refused(Reason { kind: kind_of(error), ..reason }),
            usage => usage,
        }
    }

    /// A refusal with the term that is to blame.
    pub(super) fn naming(self, term: Option<&str>) -> Self {
        match self {
            Self::Refused(reason) => {
                Self::Refused(Reason { term: term.map(str::to_owned), ..reason })
            }
            usage => usage,
        }
    }

    /// The failure of one of many, after the name of that one.
    pub(super) fn within(self, name: &str) -> Self {
        match self {
            Self::Refused(reason) => {
                Self::Refused(Reason { text: format!("{name}: {}", reason.text), ..reason })
            }
            Self::Usage(text) => Self::because(format!("{name}: {text}")),
        }
    }

    /// A refusal with what else may be behind it.
    pub(super) fn with_notes(self, notes: &[String]) -> Self {
        match self {
            Self::Refused(reason) => {
                let added = |text: String, note: &String| text + "\n  note: " + note;
                Self::Refused(Reason { text: notes.iter().fold(reason.text, added), ..reason })
            }
            Self::Usage(text) => Self::Usage(text),
        }
    }

    /// A refusal with the advice of the library.
    pub(super) fn with_advice(error: &impl Display, advice: Option<Advice>) -> Self {
        Self::refused(error, advice.as_ref().map(in_flags))
    }
}

/// The name of an error without `Error`, in the spelling of the formats: `oscillator`.
pub(super) fn kind_of<E>(_: &E) -> String {
    let path = std::any::type_name::<E>();
    let name = path.rsplit("::").next().unwrap_or_default().trim_end_matches("Error");
    let mut kind = String::new();
    for letter in name.chars().filter(|letter| letter.is_ascii_alphanumeric()) {
        if letter.is_ascii_uppercase() && !kind.is_empty() {
            kind.push('-');
        }
        kind.push(letter.to_ascii_lowercase());
    }
    match kind.as_str() {
        "string" | "" => "command".to_owned(),
        _ => kind,
    }
}

/// Advice of the library with its options as they are typed here: words of the command line, or
/// keywords inside another process.
pub(super) fn in_flags(advice: &Advice) -> String {
    let is_call = session::current().is_call();
    let option = |name: &str, value: &str| match is_call {
        true if value.parse::<f64>().is_ok() => format!("{name}={value}"),
        true => format!("{name}=\"{value}\""),
        false => format!("--{name} {value}"),
    };
    advice.spelt(|setting| match setting {
        Setting::Method(method) => option("method", method.name()),
        Setting::Order(order) => option("order", &order.to_string()),
        Setting::Degrees(degrees) => option("order", &degrees.separated()),
        Setting::Amplitude(convention) => option("amplitude", convention.name()),
        Setting::Small(name) => option("small", &name.to_string()),
        Setting::Taylor if is_call => "taylor=DEGREE".to_owned(),
        Setting::Taylor => "--taylor DEGREE".to_owned(),
        Setting::About { coordinate, position } => {
            option("about", &format!("{coordinate}={position}"))
        }
        Setting::Values if is_call => "values of the symbols".to_owned(),
        Setting::Values => "--at".to_owned(),
        Setting::Resonance(driving, linear) => option("resonance", &format!("{driving}:{linear}")),
        other => other.to_string(),
    })
}

/// The option that gives values to these names.
pub(super) fn values_of(names: &[Symbol]) -> String {
    let values: Vec<String> = names.iter().map(|name| format!("{name}=VALUE")).collect();
    format!("--at {}", values.join(","))
}

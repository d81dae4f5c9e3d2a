//! `lindstedt absorber KIND`.

use crate::absorber::{AbsorberError, AbsorberKind, AbsorberLaws, Excitation, derive};
use crate::absorber_verdict::{JudgedAbsorber, judge_absorber};
use crate::export::{absorber as drawing, json};
use crate::report::{self, AbsorberReport};
use crate::symbol::Symbol;
use crate::values::Values;
use clap::Args;

use super::answer::{Answer, Draw, no_such};
use super::derive::{exact_values, separate_values};
use super::files::width;
use super::{Common, Failure, Format, Outcome, Work, json_text, tolerance};

/// Design formulas of a vibration absorber: tuning and damping of a tuned mass damper, its cubic
/// spring where the main mass has one, thresholds of a ball in a cavity, of a pendulum between barriers
/// and of a light mass on a cubic spring
#[derive(Args)]
pub struct AbsorberArguments {
    /// The kind of absorber: a tuned mass damper; the same on a damped main mass; a nonlinear one, with a cubic spring beside that of
    /// the main mass; a vibro-impact sink, a ball in a cavity or a pendulum between barriers; a light mass on a cubic spring
    #[arg(value_parser = ["tuned", "damped", "nonlinear", "impact-sink", "pendulum-sink", "cubic-sink"])]
    kind: String,
    /// What shakes the main mass of a tuned mass damper: a force on it, or the ground; force without
    /// it
    #[arg(long, value_parser = ["force", "ground"])]
    excitation: Option<String>,
    /// A value, exact (1/20, 0.65): asks for numbers and verdicts (repeatable)
    #[arg(long, value_name = "NAME=VALUE,...")]
    at: Vec<String>,
    #[command(flatten)]
    pub common: Common,
}

impl Work for AbsorberArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &AbsorberArguments) -> Result<Outcome, Failure> {
    let laws = derive(kind(arguments)?)?;
    let common = &arguments.common;
    let values = exact_values(&arguments.at, Ok(Values::default()))?;
    let needed = match common.format() {
        _ if common.draws() => Some("a picture"),
        Format::Csv => Some("--format csv: a table"),
        _ if common.tolerance.is_some() => Some("--tolerance: a verdict"),
        _ => None,
    };
    if let (None, Some(what)) = (&values, needed) {
        return Err(Failure::refused(
            &format!("{what} of an absorber needs numbers"),
            Some(format!("add --at {}", usual_values(&laws))),
        ));
    }
    let judged = match &values {
        None => None,
        Some(values) => Some(
            judge_absorber(&laws, values, tolerance(common))
                .map_err(|error| refused(&error, &laws, &arguments.at))?,
        ),
    };
    let report = AbsorberReport { laws: &laws, judged: judged.as_ref() };
    let drawn = judged.as_ref().map(|judged| || Ok(drawing::picture(&laws, judged)?));
    let answer = Answer {
        document: &report::absorber(&report),
        width: width(common.output.as_deref()),
        picture: drawn.as_ref().map(|draw| draw as Draw),
        other: &|format| match (format, &judged) {
            (Format::Json, _) => json_text(&json::absorber(&report)),
            (Format::Csv, Some(judged)) => Ok(drawing::csv(&laws, judged)),
            (format, _) => no_such(format),
        },
    };
    Ok(Outcome {
        verdict: judged.as_ref().and_then(|judged: &JudgedAbsorber| judged.verdict),
        partial: judged.as_ref().is_some_and(|judged| judged.verdict.is_none()),
        ..answer.outcome(common)?
    })
}

/// The kind that is asked for.
fn kind(arguments: &AbsorberArguments) -> Result<AbsorberKind, Failure> {
    match (arguments.kind.as_str(), arguments.excitation.as_deref()) {
        ("tuned", Some("ground")) => Ok(AbsorberKind::Tuned(Excitation::Ground)),
        ("tuned", _) => Ok(AbsorberKind::Tuned(Excitation::Force)),
        ("damped", Some("ground")) => Ok(AbsorberKind::Damped(Excitation::Ground)),
        ("damped", _) => Ok(AbsorberKind::Damped(Excitation::Force)),
        (kind, Some(_)) => Err(Failure::Usage(format!(
            "--excitation says nothing to {kind}: it is what shakes the main mass of a tuned mass damper"
        ))),
        ("nonlinear", None) => Ok(AbsorberKind::Nonlinear),
        ("impact-sink", None) => Ok(AbsorberKind::ImpactSink),
        ("pendulum-sink", None) => Ok(AbsorberKind::PendulumSink),
        (_, None) => Ok(AbsorberKind::CubicSink),
    }
}

/// Usual values of all letters, for advice.
fn usual_values(laws: &AbsorberLaws) -> String {
    let letters = laws.kind.letters().iter();
    let values: Vec<String> =
        letters.map(|letter| format!("{}={}", letter.name, letter.example)).collect();
    values.join(",")
}

/// A refusal, with the value that it is about shown as it was typed.
fn refused(error: &AbsorberError, laws: &AbsorberLaws, at: &[String]) -> Failure {
    let name = match error {
        AbsorberError::Unknown { name, .. } | AbsorberError::Outside { name, .. } => Some(*name),
        _ => None,
    };
    let shown = name.and_then(|name| shown(name, at)).unwrap_or_default();
    match error {
        AbsorberError::Unknown { .. } => Failure::Usage(format!(
            "--at: {error}{shown}\n  help: such as --at {}",
            usual_values(laws)
        )),
        AbsorberError::Missing(names) => {
            let letters = laws.kind.letters().iter();
            let missing: Vec<String> = letters
                .filter(|letter| names.contains(&Symbol::new(letter.name)))
                .map(|letter| format!("{}={}", letter.name, letter.example))
                .collect();
            Failure::refused(error, Some(format!("add --at {}", missing.join(",")))).of_kind(error)
        }
        _ => Failure::refused(&format!("{error}{shown}"), error.help()).of_kind(error),
    }
}

/// The option that gives a value to a name, the value underlined.
fn shown(name: Symbol, at: &[String]) -> Option<String> {
    let parts = at.iter().flat_map(|text| separate_values(text));
    let part = parts
        .into_iter()
        .find(|part| part.split_once('=').is_some_and(|(own, _)| own.trim() == name.name()))?;
    let (own, value) = part.split_once('=')?;
    let indent = "--at ".len() + own.chars().count() + 1;
    Some(format!("\n  --at {part}\n  {}{}", " ".repeat(indent), "^".repeat(value.chars().count())))
}

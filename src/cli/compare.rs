//! `lindstedt compare PROBLEM --at A=1.5`.

use std::path::Path;

use crate::Oscillator;
use crate::export::{self, json};
use crate::problem::ReadingCommand;
use crate::report;
use crate::verify::comparison::{self, Comparison};
use crate::verify::{Verdict, VerificationError};
use clap::Args;

use super::answer::{Answer, no_such};
use super::derive::{Numbered, formula, named, notes_on_letters, oscillator, with_values};
use super::problem::problem;
use super::walls::ContactArguments;
use super::{Common, Failure, Format, Outcome, Work, files, json_text, tolerance, values_of};

/// Every method of the field on one equation, in one table, judged against the true motion
#[derive(Args)]
pub struct CompareArguments {
    /// An equation in quotes, a TOML file, a name of the catalogue, or - for standard input
    pub problem: String,
    #[command(flatten)]
    contacts: ContactArguments,
    /// A value, exact (1.5, 3/2, pi/3): where the methods are compared; repeatable
    #[arg(long, value_name = "NAME=VALUE,...")]
    at: Vec<String>,
    /// The small parameter; A for the amplitude
    #[arg(long, value_name = "NAME")]
    small: Option<String>,
    /// The equilibrium to swing about, x=1 say: a stable one, without this the nearest to zero, or
    /// an unstable one between two wells for motions over both
    #[arg(long, value_name = "NAME=VALUE,...")]
    about: Option<String>,
    #[command(flatten)]
    pub common: Common,
}

impl Work for CompareArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn input(&self) -> Option<&Path> {
        super::problem::path(&self.problem)
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &CompareArguments) -> Result<Outcome, Failure> {
    let problem = arguments.contacts.on(problem(&arguments.problem)?)?;
    let formula = formula(&problem, ReadingCommand::Compare)?;
    let oscillator = named(&oscillator(&formula, arguments.about.as_deref())?)?;
    let letters = oscillator.letters();
    let _letters = letters.in_force();
    let coordinate = oscillator.coordinate;
    let Numbered { oscillator, values, notes } = with_values(oscillator, &arguments.at, &problem)?;
    let values = values.unwrap_or_default();
    let small = arguments.small.as_deref().or(formula.small);
    if small.is_some() {
        oscillator
            .small_parameter(small)
            .map_err(|error| Failure::with_advice(&error, error.help()))?;
    }
    let tolerance = tolerance(&arguments.common);
    let comparison = comparison::compare(&oscillator, &values, small, tolerance).map_err(
        |error| match &error {
            VerificationError::NoMethod(refused) => {
                Failure::with_advice(&error, refused.first().and_then(|first| first.reason.help()))
            }
            VerificationError::Missing(names) => {
                Failure::refused(&error, Some(format!("add {}", values_of(names))))
            }
            VerificationError::Unknown { .. } => Failure::Usage(error.to_string()),
            _ => Failure::refused(&error, None),
        },
    )?;
    let answer = Answer {
        document: &report::comparison(&comparison),
        width: files::width(arguments.common.output.as_deref()),
        picture: Some(&|| picture(&oscillator, &comparison)),
        other: &|format| match format {
            Format::Json => json_text(&json::comparison(&comparison)),
            Format::Csv => Ok(export::comparison::csv(&comparison)),
            format => no_such(format),
        },
    };
    let passed = comparison.rows.iter().all(|row| row.verdict == Some(Verdict::Pass));
    let of_letters = comparison.rows.first();
    let of_letters =
        of_letters.map(|row| notes_on_letters(&letters, coordinate, &row.solution, true));
    let notes = notes.into_iter().chain(of_letters.into_iter().flatten());
    let notes: Vec<String> = notes.map(|note| format!("note: {note}")).collect();
    Ok(Outcome {
        verdict: Some(Verdict::from_passed(passed)),
        note: (!notes.is_empty()).then(|| notes.join("\n")),
        ..answer.outcome(&arguments.common)?
    })
}

fn picture(oscillator: &Oscillator, comparison: &Comparison) -> Result<String, Failure> {
    use crate::export::figure::backbone_figure;

    let (truth, curves) = comparison::backbones(oscillator, comparison)?;
    let at: Vec<String> =
        comparison.at.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    let caption = format!("{}; {}", comparison.equation, at.join(", "));
    let marked = comparison.at.get("A".into()).map(f64::abs);
    Ok(backbone_figure(&truth, &curves, marked, &caption)?)
}

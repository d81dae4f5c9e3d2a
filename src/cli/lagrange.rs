//! `lindstedt lagrange [FILE]`.

use std::path::{Path, PathBuf};

use crate::audit::paper;
use crate::export::json;
use crate::mechanics::study;
use crate::problem::{Problem, ReadingCommand};
use crate::report;
use clap::Args;

use super::answer::{Answer, no_such};
use super::derive::exact_values;
use super::files::width;
use super::problem::from_file;
use super::{Common, Failure, Format, Outcome, Work, json_text};

/// Energies and forces to equations of motion, units checked, dimensionless groups, places of rest
/// and modes
#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
pub struct LagrangeArguments {
    /// A TOML file with [lagrangian], or - for standard input; without it the paper's pendulum, its
    /// equations (1) to (8) beside what follows
    pub file: Option<PathBuf>,
    /// A value of a parameter (1.5, 3/2, pi/3): with all of them the modes get numbers; repeatable
    #[arg(long, value_name = "NAME=VALUE,...")]
    at: Vec<String>,
    #[command(flatten)]
    pub common: Common,
}

impl Work for LagrangeArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn input(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &LagrangeArguments) -> Result<Outcome, Failure> {
    let common = &arguments.common;
    if common.tolerance.is_some() {
        return Err(Failure::Usage(
            "--tolerance belongs to a verdict, and a derivation of equations has none: leave it out".to_owned(),
        ));
    }
    if common.plot.is_some() {
        return Err(Failure::Usage(
            "--plot: equations of motion have no picture; `lindstedt simulate` draws the motion of the file".to_owned(),
        ));
    }
    let (mut question, problem) = match &arguments.file {
        None => (paper::mechanism(), Problem::default()),
        Some(path) => {
            let problem = from_file(path)?;
            problem.check_keys(ReadingCommand::Lagrange)?;
            let question =
                problem.mechanism().map_err(|error| Failure::refused(&error, error.help()))?;
            (question, problem)
        }
    };
    question.values =
        exact_values(&arguments.at, problem.exact_values())?.unwrap_or_default().numbers();
    let study = study(question).map_err(|error| Failure::refused(&error, error.help()))?;
    // The printed equations stand beside the derived ones where the mechanism is the paper's.
    let findings = match &arguments.file {
        None => paper::findings()?,
        Some(_) => Vec::new(),
    };
    let mut document = report::mechanism(&study);
    if !findings.is_empty() {
        document.sections.push(report::paper_equations(&findings));
    }
    let answer = Answer {
        document: &document,
        width: width(common.output.as_deref()),
        picture: None,
        other: &|format| match format {
            Format::Json => {
                let mut document = json::lagrangian(&study);
                document.findings = findings.clone();
                json_text(&document)
            }
            format => no_such(format),
        },
    };
    answer.outcome(common)
}

//! `lindstedt orbits PROBLEM --wall "x < d" --restitution e`.

use std::path::Path;

use crate::Oscillator;
use crate::export::{json, orbits as drawing};
use crate::orbits::{
    CHART_SIZE, FoundOrbits, ImpactEquation, OrbitChart, OrbitError, OrbitRequest, OrbitSweep,
    VaryingParameter, certify_orbits, chart_orbits, find_orbits, laws, sweep_orbits,
};
use crate::problem::{Problem, ReadingCommand};
use crate::report::{self, OrbitCertificateReport, OrbitsReport};
use crate::values::Values;
use clap::Args;

use super::answer::{Answer, Draw, no_such};
use super::certify::{orbits_printed, without_picture};
use super::derive::{exact_values, formula, oscillator};
use super::files::width;
use super::problem::problem;
use super::response::range;
use super::walls::WallArguments;
use super::{Common, Failure, Format, Outcome, Work, json_text, session, tolerance, values_of};

/// Periodic motions of a linear driven oscillator that hits rigid walls: speed, phase and stability in
/// closed form, each orbit beside a simulation; charts over two parameters
#[derive(Args)]
pub struct OrbitsArguments {
    /// An equation in quotes, a TOML file, a name of the catalogue, or - for standard input
    problem: String,
    #[command(flatten)]
    walls: WallArguments,
    /// Impacts in a period of the orbit: 1 in closed form, with symmetric orbits between two walls;
    /// more by a search
    #[arg(long, value_name = "K", default_value_t = 1, allow_hyphen_values = true)]
    impacts: u32,
    /// Periods of the drive in a period of the orbit, one number or from N to M; 1:3 without it
    #[arg(long, value_name = "N[:M]", allow_hyphen_values = true)]
    periods: Option<String>,
    /// A value, exact (1/20, 0.65): asks for numbers and verdicts (repeatable)
    #[arg(long, value_name = "NAME=VALUE,...")]
    at: Vec<String>,
    /// A parameter, and from where to where: impact speeds along it (F=0.05:1.5)
    #[arg(long, value_name = "NAME=FROM:TO", allow_hyphen_values = true)]
    vary: Option<String>,
    /// A second parameter, and from where to where: a chart of where orbits exist and are stable
    #[arg(long, value_name = "NAME=FROM:TO", allow_hyphen_values = true, requires = "vary")]
    along: Option<String>,
    /// Prove each orbit: that there is exactly one near its numbers, that it touches no wall between
    /// its impacts, and whether it is stable; FILE.json of --output is a certificate that `check` reads
    #[arg(long, conflicts_with_all = ["vary", "along"])]
    certify: bool,
    #[command(flatten)]
    pub common: Common,
}

impl Work for OrbitsArguments {
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

/// The results beside the laws.
enum Computed {
    Nothing,
    Found(FoundOrbits),
    Sweep(OrbitSweep),
    Chart(OrbitChart),
}

fn run(arguments: &OrbitsArguments) -> Result<Outcome, Failure> {
    let problem = problem(&arguments.problem)?;
    if arguments.certify {
        without_picture(&arguments.common)?;
    }
    let oscillator = oscillator(&formula(&problem, ReadingCommand::Orbits)?, None)?;
    let walls = arguments.walls.walls(&problem)?;
    let refuse = |error: OrbitError| refused(&oscillator, error);
    let question = ImpactEquation::new(&oscillator, &walls).map_err(refuse)?;
    let laws = laws(&question).map_err(refuse)?;
    let computed = compute(arguments, &problem, &question).map_err(|refused| match refused {
        Refused::Failure(failure) => failure,
        Refused::Orbit(error) => refuse(error),
    })?;
    if arguments.certify {
        return match &computed {
            Computed::Found(found) => proved(&oscillator, &question, found, &arguments.common),
            _ => Err(Failure::refused(
                &"--certify: a proof of orbits needs numbers",
                Some(format!("add {}", values_of(&question.parameters()))),
            )),
        };
    }
    let mut report =
        OrbitsReport { question: &question, laws: &laws, found: None, sweep: None, chart: None };
    match &computed {
        Computed::Nothing => needs_numbers(&arguments.common, &question)?,
        Computed::Found(found) => report.found = Some(found),
        Computed::Sweep(sweep) => report.sweep = Some(sweep),
        Computed::Chart(chart) => report.chart = Some(chart),
    }
    let drawn = || match &computed {
        Computed::Sweep(sweep) => Ok(drawing::sweep_picture(&question, sweep)?),
        Computed::Chart(chart) => Ok(drawing::chart_picture(&question, chart)?),
        Computed::Nothing | Computed::Found(_) => Err(Failure::because(
            "a picture of orbits needs a parameter that varies\n  help: --vary NAME=FROM:TO, and --along NAME=FROM:TO for a chart",
        )),
    };
    let is_drawn = matches!(&computed, Computed::Sweep(_) | Computed::Chart(_));
    let answer = Answer {
        document: &report::orbits(&report),
        width: width(arguments.common.output.as_deref()),
        picture: (is_drawn || arguments.common.draws()).then_some(&drawn as Draw),
        other: &|format| match (format, &computed) {
            (Format::Json, _) => json_text(&json::orbits(&report)),
            (Format::Csv, Computed::Found(found)) => Ok(drawing::csv(found)),
            (Format::Csv, Computed::Sweep(sweep)) => Ok(drawing::sweep_csv(sweep)),
            (Format::Csv, Computed::Chart(chart)) => Ok(drawing::chart_csv(chart)),
            (format, _) => no_such(format),
        },
    };
    Ok(Outcome {
        verdict: report.found.and_then(|found| found.verdict),
        ..answer.outcome(&arguments.common)?
    })
}

/// The proofs of the orbits that were found.
fn proved(
    oscillator: &Oscillator,
    question: &ImpactEquation,
    found: &FoundOrbits,
    common: &Common,
) -> Result<Outcome, Failure> {
    let interrupt = session::supervision().interrupt;
    let proofs =
        certify_orbits(question, found, interrupt).map_err(|error| refused(oscillator, error))?;
    let not_proved = proofs.proofs.iter().zip(&found.orbits).filter_map(|(proof, own)| {
        let speed = own.orbit.impacts.first()?.speed;
        let reason = proof.as_ref()?.as_ref().err()?;
        Some((own.orbit.periods, speed, reason))
    });
    let report = OrbitCertificateReport {
        certificate: &proofs.certificate,
        proved: proofs.proofs.iter().flatten().flatten().collect(),
        not_proved: not_proved.collect(),
        not_followed: proofs.proofs.iter().filter(|proof| proof.is_none()).count(),
    };
    if report.proved.is_empty() {
        return Err(match report.not_proved.first() {
            Some((.., reason)) => Failure::refused(&format!("no orbit is proved: {reason}"), None),
            None => Failure::because("there is no orbit to prove: no motion follows one"),
        });
    }
    orbits_printed(&report, common)
}

/// A failure with its words, or an error whose term is to be shown in the equation.
enum Refused {
    Failure(Failure),
    Orbit(OrbitError),
}

impl From<Failure> for Refused {
    fn from(failure: Failure) -> Self {
        Self::Failure(failure)
    }
}

impl From<OrbitError> for Refused {
    fn from(error: OrbitError) -> Self {
        Self::Orbit(error)
    }
}

/// The orbits at the values, along a parameter or over two.
fn compute(
    arguments: &OrbitsArguments,
    problem: &Problem,
    question: &ImpactEquation,
) -> Result<Computed, Refused> {
    let request = OrbitRequest {
        impacts: arguments.impacts,
        periods: periods(arguments, problem)?,
        tolerance: tolerance(&arguments.common),
        interrupt: session::supervision().interrupt,
    };
    if request.impacts == 0 {
        return Err(Failure::Usage(
            "--impacts 0: an impact orbit has one impact or more".to_owned(),
        )
        .into());
    }
    let vary = arguments.vary.as_deref().or(problem.vary.as_deref());
    let along = arguments.along.as_deref().or(problem.along.as_deref());
    let values = exact_values(&arguments.at, problem.values_of_motion())?;
    let varying = |option: &str, text: &str| {
        range(option, text).map(|(name, range)| VaryingParameter { name, range })
    };
    let Some(vary) = vary else {
        // A question without letters has its numbers.
        let is_asked = values.is_some() || question.parameters().is_empty();
        return match is_asked {
            true => {
                Ok(Computed::Found(find_orbits(question, &values.unwrap_or_default(), &request)?))
            }
            false => Ok(Computed::Nothing),
        };
    };
    if request.impacts != 1 {
        return Err(Failure::Usage(format!(
            "--impacts {}: along a parameter are orbits in closed form, which have one impact, or one on each of two walls",
            request.impacts
        ))
        .into());
    }
    let vary = varying("--vary", vary)?;
    let values = without(values.unwrap_or_default(), &[vary.name], arguments);
    match along {
        None => Ok(Computed::Sweep(sweep_orbits(question, &values, vary, &request)?)),
        Some(along) => {
            let along = varying("--along", along)?;
            let values = without(values, &[along.name], arguments);
            Ok(Computed::Chart(chart_orbits(
                question,
                &values,
                [along, vary],
                CHART_SIZE,
                &request,
            )?))
        }
    }
}

/// The values without those of a file for parameters that vary; of the command line they are refused.
fn without(values: Values, names: &[crate::Symbol], arguments: &OrbitsArguments) -> Values {
    match arguments.at.is_empty() {
        true => values.split(names).1,
        false => values,
    }
}

/// The range of the numbers of periods.
fn periods(arguments: &OrbitsArguments, problem: &Problem) -> Result<[u32; 2], Failure> {
    let Some(text) = &arguments.periods else {
        return Ok(problem.periods.map_or(OrbitRequest::default().periods, |own| [own, own]));
    };
    let form = || {
        Failure::Usage(format!(
            "--periods {text}: expected whole numbers from 1 on, N or N:M, such as 1:3"
        ))
    };
    let number =
        |text: &str| text.trim().parse::<u32>().ok().filter(|own| *own > 0).ok_or_else(form);
    let (from, to) = match text.split_once(':') {
        Some((from, to)) => (number(from)?, number(to)?),
        None => (number(text)?, number(text)?),
    };
    if from > to {
        return Err(form());
    }
    Ok([from, to])
}

/// Refuses what letters alone do not give.
fn needs_numbers(common: &Common, question: &ImpactEquation) -> Result<(), Failure> {
    let needed = match common.format() {
        Format::Csv => "--format csv: a table",
        _ if common.draws() => "a picture",
        _ if common.tolerance.is_some() => "--tolerance: a verdict",
        _ => return Ok(()),
    };
    Err(Failure::refused(
        &format!("{needed} of orbits needs numbers"),
        Some(format!("add {}", values_of(&question.parameters()))),
    ))
}

/// A refusal, with the term that it names shown in the equation.
fn refused(oscillator: &Oscillator, error: OrbitError) -> Failure {
    let place = error.term().and_then(|term| oscillator.typed.locate(term));
    let shown = place.map_or(String::new(), |[line, carets]| format!("\n  {line}\n  {carets}"));
    let help = match &error {
        OrbitError::Missing(names) => Some(format!("add {}", values_of(names))),
        _ => error.help(),
    };
    match &error {
        OrbitError::Unknown { .. } => Failure::Usage(format!("--at: {error}")),
        OrbitError::Count { .. } | OrbitError::Range(_) => Failure::Usage(error.to_string()),
        _ => {
            Failure::refused(&format!("{error}{shown}"), help).of_kind(&error).naming(error.term())
        }
    }
}

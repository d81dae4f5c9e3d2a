//! `lindstedt fit FILE [EQUATION]`.

use std::path::Path;

use crate::export::{fit as drawing, json};
use crate::fit::answer::{Answer as Decay, FitError, FitOptions, fit, fit_laws};
use crate::fit::impacts::{ImpactAnswer, fit_impacts};
use crate::fit::laws::Law;
use crate::fit::motion::Quantity;
use crate::fit::record::{Column, ReadError, ReadOptions, ReadRecord, Record, read, read_columns};
use crate::fit::response::{FrequencyResponse, ResponseFit, ResponseRow, fit_response};
use crate::fit::tables::{TableAnswer, TableRow, fit_table};
use crate::report::{self, FitReport};
use crate::symbol::Symbol;
use crate::values::Values;
use clap::{Args, ValueEnum};

use super::answer::{Answer, Draw, no_such};
use super::derive::exact_values;
use super::files::width;
use super::{Common, Failure, Format, Outcome, Work, json_text, read_at_most};

/// The law of a measured motion, with the standard errors of its parameters, and what the measurement
/// excludes
#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
pub struct FitArguments {
    /// A table of numbers, with commas, semicolons, tabs or blanks between them; - for standard input
    file: String,
    /// Another file with a record of the same thing, fitted together with the first (repeatable)
    #[arg(long, value_name = "FILE")]
    also: Vec<String>,
    /// An equation whose letters are to be found, such as "x'' + c*x' + k*x + b*x^3 = 0"; repeatable,
    /// without it the laws of a list: springs and pendulum, each with every damping
    equation: Vec<String>,
    /// The content of the file: times and values of a motion; frequencies (and damping ratios) against
    /// amplitudes; amplitudes (and phases) against the frequency of a drive; or the times of impacts of a
    /// ball
    #[arg(long, value_name = "KIND", default_value = "decay")]
    data: Kind,
    /// The column of time, by its name or its number from 1
    #[arg(long, value_name = "COLUMN")]
    time: Option<String>,
    /// The column of values, by its name or its number from 1; several are records of the same thing, and
    /// are fitted together; of a backbone those of amplitude, frequency and damping, of a response those of
    /// frequency, amplitude, phase, and letters of the equation (repeatable)
    #[arg(long, value_name = "COLUMN")]
    column: Vec<String>,
    /// The quantity that was measured
    #[arg(long, default_value = "displacement")]
    quantity: Measured,
    /// The values are angles in radians, so that a pendulum is among the laws; a head such as
    /// angle (deg) says so as well
    #[arg(long)]
    angle: bool,
    /// The first values of the letters of an equation, from which the search begins
    #[arg(long, value_name = "NAME=VALUE,...", allow_hyphen_values = true)]
    start: Vec<String>,
    /// The standard deviation of the noise, of impacts that of a time; without it found from what the
    /// law leaves over
    #[arg(long, value_name = "SIZE", value_parser = super::positive, allow_hyphen_values = true)]
    noise: Option<f64>,
    /// Keep the samples that lie far from the law
    #[arg(long)]
    keep_outliers: bool,
    /// With csv and pictures: the law beyond the record, until this time of the file, with its standard
    /// error
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    until: Option<f64>,
    /// The gravity under which a ball bounces
    #[arg(long, value_parser = super::positive, default_value_t = 9.81, allow_hyphen_values = true)]
    gravity: f64,
    #[command(flatten)]
    pub common: Common,
}

/// The content of a file.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    Decay,
    Backbone,
    Response,
    Impacts,
}

/// The quantity of a record.
#[derive(Clone, Copy, ValueEnum)]
enum Measured {
    Displacement,
    Velocity,
    Acceleration,
}

impl Work for FitArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn input(&self) -> Option<&Path> {
        Some(Path::new(&self.file))
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

/// The largest file that is read, in bytes.
const LARGEST: usize = 64 << 20;

fn run(arguments: &FitArguments) -> Result<Outcome, Failure> {
    if arguments.common.tolerance.is_some() {
        return Err(Failure::Usage(
            "--tolerance: the errors of a fit are those of its parameters".to_owned(),
        ));
    }
    arguments.check()?;
    let text = measurement(&arguments.file)?;
    match arguments.data {
        Kind::Decay => {
            let (records, answer) = decay(arguments, &text)?;
            let until = arguments.until;
            answered(
                &FitReport::Decay { records: &records, answer: &answer, until },
                &arguments.common,
            )
        }
        Kind::Backbone => {
            let (rows, answer) = backbone(arguments, &text)?;
            answered(&FitReport::Backbone { rows: &rows, answer: &answer }, &arguments.common)
        }
        Kind::Response => {
            let (response, fit) = response(arguments, &text)?;
            answered(&FitReport::Response { response: &response, fit: &fit }, &arguments.common)
        }
        Kind::Impacts => {
            let answer = impacts(arguments, &text)?;
            answered(&FitReport::Impacts(&answer), &arguments.common)
        }
    }
}

/// The text of a measurement.
fn measurement(file: &str) -> Result<String, Failure> {
    let text = read_at_most(Path::new(file), LARGEST)?;
    match text.len() > LARGEST {
        true => Err(Failure::because(format!(
            "{file} is larger than the {LARGEST} bytes that a measurement may have"
        ))),
        false => Ok(text),
    }
}

impl FitArguments {
    /// Refuses options without effect on this kind of measurement.
    fn check(&self) -> Result<(), Failure> {
        let is_decay = self.data == Kind::Decay;
        let has_equation = is_decay || self.data == Kind::Response;
        let foreign = [
            ("an equation", !self.equation.is_empty(), has_equation),
            ("--also", !self.also.is_empty(), is_decay),
            ("--time", self.time.is_some(), is_decay),
            ("--start", !self.start.is_empty(), has_equation && !self.equation.is_empty()),
            ("--keep-outliers", self.keep_outliers, is_decay),
            ("--until", self.until.is_some(), is_decay),
            ("--angle", self.angle, matches!(self.data, Kind::Decay | Kind::Backbone)),
            ("--noise", self.noise.is_some(), matches!(self.data, Kind::Decay | Kind::Impacts)),
        ];
        match foreign.iter().find(|(_, is_given, is_taken)| *is_given && !is_taken) {
            Some((option, ..)) if *option == "--start" && has_equation => Err(Failure::Usage(
                "--start: it is of the letters of an equation: write the equation as well"
                    .to_owned(),
            )),
            Some((option, ..)) => {
                let kind = self.data.to_possible_value();
                let kind = kind.as_ref().map_or("decay", |kind| kind.get_name());
                Err(Failure::Usage(format!("{option}: it has no effect with --data {kind}")))
            }
            None => Ok(()),
        }
    }
}

fn unread(error: &ReadError) -> Failure {
    let others = match error {
        ReadError::OneColumn { .. } => "; times of impacts alone take --data impacts",
        _ => "",
    };
    Failure::refused(error, Some(format!("{}{others}", error.help()))).of_kind(error)
}

fn unfitted(error: &FitError) -> Failure {
    Failure::refused(error, Some(error.help())).of_kind(error)
}

/// The records of a motion and their laws.
fn decay(arguments: &FitArguments, text: &str) -> Result<(Vec<ReadRecord>, Decay), Failure> {
    let options = ReadOptions {
        time: arguments.time.clone(),
        values: arguments.column.clone(),
        quantity: match arguments.quantity {
            Measured::Displacement => Quantity::Displacement,
            Measured::Velocity => Quantity::Velocity,
            Measured::Acceleration => Quantity::Acceleration,
        },
        is_angle: arguments.angle,
    };
    let mut read_records = read(text, &options).map_err(|error| unread(&error))?;
    for file in &arguments.also {
        let text = measurement(file)?;
        let further = read(&text, &options).map_err(|error| unread(&error).within(file))?;
        read_records.extend(further);
    }
    let records: Vec<Record> = read_records.iter().map(|read| read.record.clone()).collect();
    let options = FitOptions { noise: arguments.noise, keep_outliers: arguments.keep_outliers };
    if arguments.equation.is_empty() {
        let answer = fit(&records, &options).map_err(|error| unfitted(&error))?;
        return Ok((read_records, answer));
    }
    let start = exact_values(&arguments.start, Ok(Values::default()))?.unwrap_or_default();
    let mut laws = vec![];
    for text in &arguments.equation {
        let law = law(text)?;
        let values = start_of(&law, &start, &[])?;
        laws.push((law, values));
    }
    let answer = fit_laws(&records, &laws, &options).map_err(|error| unfitted(&error))?;
    Ok((read_records, answer))
}

/// The law of an equation.
fn law(equation: &str) -> Result<Law, Failure> {
    Law::parse(equation).map_err(|error| Failure::refused(&error, Some(error.help().to_owned())))
}

/// The first values of all letters of a law, zero of those that are `known`; `None` without any.
///
/// # Errors
/// A letter without a value beside others that have one.
fn start_of(law: &Law, start: &Values, known: &[Symbol]) -> Result<Option<Vec<f64>>, Failure> {
    let value = |name: &Symbol| match known.contains(name) {
        true => Some(0.0),
        false => start.get(*name),
    };
    let values: Vec<Option<f64>> = law.parameters.iter().map(value).collect();
    let missing = values.iter().zip(&law.parameters).find(|(value, _)| value.is_none());
    match missing {
        Some((_, name)) if !start.is_empty() => Err(Failure::Usage(format!(
            "--start: a value for {name} of `{}` is missing: give one for each letter",
            law.equation
        ))),
        Some(_) => Ok(None),
        None => Ok(Some(values.into_iter().flatten().collect())),
    }
}

/// The rows of a table of frequencies, and their laws.
fn backbone(arguments: &FitArguments, text: &str) -> Result<(Vec<TableRow>, TableAnswer), Failure> {
    let columns = read_columns(text, &arguments.column, 3).map_err(|error| unread(&error))?;
    let [amplitude, frequency, rest @ ..] = columns.as_slice() else {
        return Err(Failure::because(
            "a backbone needs a column of amplitudes and one of frequencies".to_owned(),
        ));
    };
    let factor = to_angular(frequency);
    let rows = amplitude.values.iter().zip(&frequency.values).enumerate();
    let rows = rows.map(|(place, (amplitude, frequency))| TableRow {
        amplitude: *amplitude,
        frequency: factor * frequency,
        damping: rest.first().and_then(|damping| damping.values.get(place).copied()),
    });
    let rows: Vec<TableRow> = rows.collect();
    let answer = fit_table(&rows, arguments.angle)
        .map_err(|error| Failure::refused(&error, Some(error.help().to_owned())).of_kind(&error))?;
    Ok((rows, answer))
}

/// The factor from the frequencies of a column to angular ones, which they are unless the head says that they
/// are cycles.
fn to_angular(frequency: &Column) -> f64 {
    let is_in_cycles = frequency.name.to_lowercase().contains("hz");
    if is_in_cycles { std::f64::consts::TAU } else { 1.0 }
}

/// The frequency response of a table, and the law of an equation with a drive.
fn response(
    arguments: &FitArguments,
    text: &str,
) -> Result<(FrequencyResponse, ResponseFit), Failure> {
    /// The largest number of columns of a table.
    const MOST: usize = 16;
    let [equation] = arguments.equation.as_slice() else {
        return Err(Failure::Usage(
            "--data response: one equation with a drive is needed, such as \"x'' + c*x' + k*x + b*x^3 = F*cos(Omega*t)\""
                .to_owned(),
        ));
    };
    let law = law(equation)?;
    let columns = read_columns(text, &arguments.column, MOST).map_err(|error| unread(&error))?;
    let [frequency, amplitude, rest @ ..] = columns.as_slice() else {
        return Err(Failure::because(
            "a response needs a column of frequencies and one of amplitudes".to_owned(),
        ));
    };
    let phase = rest.iter().find(|column| column.name.to_lowercase().starts_with("phase"));
    let of_letter = |name: &Symbol| {
        let column = rest.iter().find(|column| column.name == name.to_string());
        column.map(|column| (*name, column.values.clone()))
    };
    let known: Vec<(Symbol, Vec<f64>)> = law.parameters.iter().filter_map(of_letter).collect();
    let factor = to_angular(frequency);
    let rows = frequency.values.iter().zip(&amplitude.values).enumerate();
    let rows = rows.map(|(place, (frequency, amplitude))| ResponseRow {
        frequency: factor * frequency,
        amplitude: *amplitude,
        phase: phase.and_then(|phase| phase.values.get(place).copied()),
    });
    let response = FrequencyResponse { rows: rows.collect(), known };
    let start = exact_values(&arguments.start, Ok(Values::default()))?.unwrap_or_default();
    let mut given: Vec<Symbol> = response.known.iter().map(|(name, _)| *name).collect();
    given.extend(law.drive_frequency());
    let start = start_of(&law, &start, &given)?.filter(|_| !start.is_empty());
    let fit = fit_response(&law, &response, start.as_deref())
        .map_err(|error| Failure::refused(&error, Some(error.help().to_owned())).of_kind(&error))?;
    Ok((response, fit))
}

/// The laws of the impacts of a ball.
fn impacts(arguments: &FitArguments, text: &str) -> Result<ImpactAnswer, Failure> {
    let columns = read_columns(text, &arguments.column, 1).map_err(|error| unread(&error))?;
    let times = columns.first().map(|column| column.values.as_slice()).unwrap_or_default();
    fit_impacts(times, arguments.gravity, arguments.noise)
        .map_err(|error| Failure::refused(&error, Some(error.help().to_owned())).of_kind(&error))
}

/// The answer in the format that is asked for.
fn answered(report: &FitReport, common: &Common) -> Result<Outcome, Failure> {
    let drawn = || Ok(drawing::picture(report)?);
    Answer {
        document: &report::fit(report),
        width: width(common.output.as_deref()),
        picture: Some(&drawn as Draw),
        other: &|format| match format {
            Format::Json => json_text(&json::fit(report)),
            Format::Csv => Ok(drawing::csv(report)),
            Format::Toml => drawing::problem(report).ok_or_else(|| {
                Failure::because("a law of restitution is no equation of motion".to_owned())
            }),
            format => no_such(format),
        },
    }
    .outcome(common)
}

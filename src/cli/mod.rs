//! Arguments -> calls -> printing: the only place that reads or prints. One file per command.
//!
//! Results go to standard output or the file of `--output`, all else to standard error. Exit codes: 0 done, 1 refused or
//! failed, 2 wrong usage, 3 verdict failed, 70 internal error.

mod catalog;
mod compare;
mod derive;
mod impact;
mod simulate;

use std::fmt::Display;
use std::io::{ErrorKind, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use clap::{Args, Parser, Subcommand, ValueEnum};
use lindstedt::problem::LARGEST_FILE;
use lindstedt::verify::{DEFAULT_TOLERANCE, Verdict};

/// Closed-form approximations of nonlinear vibrations, derived exactly and judged against the true motion.
#[derive(Parser)]
#[command(name = "lindstedt", version, max_term_width = 100, after_help = AFTER_HELP)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

const AFTER_HELP: &str = "\
Without a command: lindstedt impact, the paper's pendulum and barrier.

Exit codes: 0 done; 1 the problem was refused or failed; 2 wrong usage; 3 verdict failed (with --tolerance).";

#[derive(Subcommand)]
enum Command {
    /// Derive the frequency law and the motion of an oscillator, to an order
    Derive(derive::Arguments),
    /// Every method of the field on one equation, in one table, judged against the true motion
    Compare(compare::Arguments),
    /// The three phases of a pendulum that hits an elastic barrier, in closed form, checked by Runge-Kutta
    Impact(impact::Arguments),
    /// The paper's equation (7) in full, event by event: trajectory, impacts, energy, rest time
    Simulate(simulate::Arguments),
    /// List the classical oscillators that `derive` knows by name
    Catalog(catalog::Arguments),
}

/// What every command takes.
#[derive(Args, Clone)]
struct Common {
    /// What to print
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Write the result to this file instead of standard output
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draw to this SVG file: the motion against Runge-Kutta; of compare, omega against the amplitude
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// Exit with code 3 if a verdict is worse than this relative error (verdicts use 0.01 without it)
    #[arg(long, value_name = "R", value_parser = positive)]
    tolerance: Option<f64>,
    /// Print results only, no notes
    #[arg(long)]
    quiet: bool,
    /// Give up after so many seconds
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    timeout: Option<f64>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    Text,
    Latex,
    Json,
    Csv,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("expected a positive number".to_owned()),
    }
}

/// Why a command ends without its result.
enum Failure {
    /// Exit code 1: the problem was refused, or something failed.
    Refused(String),
    /// Exit code 2.
    Usage(String),
}

impl Failure {
    /// A refusal with its way forward.
    fn refused(error: &impl Display, help: Option<String>) -> Self {
        Self::Refused(match help {
            Some(help) => format!("{error}\n  help: {help}"),
            None => error.to_string(),
        })
    }
}

/// What a command hands back.
struct Outcome {
    /// The result.
    text: String,
    /// A picture and where it goes.
    picture: Option<(PathBuf, String)>,
    /// Said on standard error.
    note: Option<String>,
    /// The verdict, where there is one.
    verdict: Option<Verdict>,
}

/// The program.
pub fn run() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // `--help` and `--version` are results and succeed; a closed pipe is no failure of theirs.
            let code = u8::try_from(error.exit_code()).unwrap_or(2);
            let _ = error.print();
            return ExitCode::from(code);
        }
    };
    let command = cli
        .command
        .unwrap_or_else(|| Command::Impact(impact::Arguments::default()));
    let common = match &command {
        Command::Derive(arguments) => arguments.common.clone(),
        Command::Compare(arguments) => arguments.common.clone(),
        Command::Impact(arguments) => arguments.common.clone(),
        Command::Simulate(arguments) => arguments.common.clone(),
        Command::Catalog(arguments) => arguments.common.clone(),
    };
    let (sender, receiver) = channel();
    // The work has a thread of its own so that a time limit can end it, wherever it is.
    let worker = std::thread::spawn(move || {
        let outcome = match command {
            Command::Derive(arguments) => derive::run(&arguments),
            Command::Compare(arguments) => compare::run(&arguments),
            Command::Impact(arguments) => impact::run(&arguments),
            Command::Simulate(arguments) => simulate::run(&arguments),
            Command::Catalog(arguments) => catalog::run(&arguments),
        };
        let _ = sender.send(outcome);
    });
    let outcome = match common.timeout {
        None => receiver.recv().map_err(|_| RecvTimeoutError::Disconnected),
        Some(seconds) => {
            let limit = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
            receiver.recv_timeout(limit)
        }
    };
    match outcome {
        Ok(Ok(outcome)) => finish(outcome, &common),
        Ok(Err(Failure::Refused(message))) => fail(1, &message),
        Ok(Err(Failure::Usage(message))) => fail(2, &message),
        Err(RecvTimeoutError::Timeout) => {
            let seconds = common.timeout.unwrap_or_default();
            fail(
                1,
                &format!("stopped after {seconds} s without a result\n  help: lower the order, or raise --timeout"),
            )
        }
        Err(RecvTimeoutError::Disconnected) => {
            let _ = worker.join();
            fail(70, "internal error: please report the command and its input")
        }
    }
}

fn finish(outcome: Outcome, common: &Common) -> ExitCode {
    if let Some((path, picture)) = &outcome.picture
        && let Err(error) = write_file(path, picture)
    {
        return fail(1, &error);
    }
    if let Some(note) = outcome.note.filter(|_| !common.quiet) {
        eprintln!("{note}");
    }
    let written = match &common.output {
        Some(path) => write_file(path, &outcome.text),
        None => match std::io::stdout().lock().write_all(outcome.text.as_bytes()) {
            Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(format!("standard output: {error}")),
            _ => Ok(()),
        },
    };
    match written {
        Err(error) => fail(1, &error),
        Ok(()) if common.tolerance.is_some() && outcome.verdict == Some(Verdict::Fail) => ExitCode::from(3),
        Ok(()) => ExitCode::SUCCESS,
    }
}

fn fail(code: u8, message: &str) -> ExitCode {
    let _ = writeln!(std::io::stderr(), "error: {message}");
    ExitCode::from(code)
}

fn write_file(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("cannot write {}: {error}", path.display()))
}

/// Refuses `--format csv` where there is no trajectory.
fn no_table<T>() -> Result<T, Failure> {
    Err(Failure::Usage(
        "there is no table of comma-separated values here: --format csv belongs to `lindstedt simulate`".to_owned(),
    ))
}

/// The text of a file, or of standard input for `-`; never more than a problem may have.
fn read(path: &Path) -> Result<String, Failure> {
    let name = if path.as_os_str() == "-" {
        "standard input".to_owned()
    } else {
        path.display().to_string()
    };
    let failure = |error: std::io::Error| Failure::Refused(format!("cannot read {name}: {error}"));
    let limit = LARGEST_FILE as u64 + 1;
    let mut bytes = Vec::new();
    if path.as_os_str() == "-" {
        std::io::stdin()
            .lock()
            .take(limit)
            .read_to_end(&mut bytes)
            .map_err(failure)?;
    } else {
        std::fs::File::open(path)
            .map_err(failure)?
            .take(limit)
            .read_to_end(&mut bytes)
            .map_err(failure)?;
    }
    String::from_utf8(bytes).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        Failure::Refused(format!(
            "{name} is not UTF-8 text: byte {place} belongs to no character"
        ))
    })
}

fn tolerance(common: &Common) -> f64 {
    common.tolerance.unwrap_or(DEFAULT_TOLERANCE)
}

fn json_text(document: &serde_json::Value) -> String {
    format!("{document:#}\n")
}

/// Refuses `--plot` where pictures were left out of the build.
#[cfg(not(feature = "plot"))]
fn no_pictures<T>() -> Result<T, Failure> {
    Err(Failure::Refused(
        "this build draws no pictures: build it with the feature `plot`".to_owned(),
    ))
}

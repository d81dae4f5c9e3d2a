//! Arguments -> calls -> printing: the only place that reads or prints. One file per command.
//!
//! In: the arguments, a problem file, standard input. Out: a result in the format asked for, a picture, and the exit code. What is
//! computed and what it says comes from the library; here options are read, and refusals get the names of the options.
//!
//! Results go to standard output or the file of `--output`, all else to standard error. Exit codes: 0 done, 1 refused or
//! failed, 2 wrong usage, 3 verdict failed, 4 stopped before the end with a partial result, 70 internal error.

mod answer;
mod audit;
mod catalog;
mod certify;
mod compare;
mod derive;
mod files;
mod friction;
mod impact;
mod lagrange;
mod materials;
mod optimize;
mod primary;
mod problem;
mod progress;
mod response;
mod schema;
mod simulate;
mod stability;
mod trajectory;

use std::fmt::Display;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};
use lindstedt::export::code::Language;
use lindstedt::export::{is_invisible, printable};
use lindstedt::problem::LARGEST_FILE;
use lindstedt::solution::{Advice, Setting};
use lindstedt::verify::{DEFAULT_TOLERANCE, Verdict};
use serde::Serialize;

/// Closed-form approximations of nonlinear vibrations, derived exactly and judged against the true motion.
#[derive(Parser)]
#[command(name = "lindstedt", version, max_term_width = 100, after_help = AFTER_HELP)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

const AFTER_HELP: &str = "\
Without a command: lindstedt impact, the paper's pendulum and barrier.

Exit codes: 0 done; 1 the problem was refused or failed; 2 wrong usage; 3 verdict failed (with --tolerance; audit and
paper always); 4 stopped before the end: what is printed is partial and says so.";

#[derive(Subcommand)]
enum Command {
    /// Derive the frequency law and the motion of an oscillator, to an order
    Derive(derive::Arguments),
    /// Every method of the field on one equation, in one table, judged against the true motion
    Compare(compare::Arguments),
    /// The three phases of a pendulum that hits an elastic barrier, in closed form, checked by Runge-Kutta
    Impact(impact::Arguments),
    /// The paper's equation (7) in full, event by event: trajectory, impacts, energy, rest time; or any equation or mechanism
    Simulate(simulate::Arguments),
    /// Steady states of a driven or self-excited oscillator: every branch with its stability, folds, period doublings, backbone
    Response(response::Arguments),
    /// The arctangent in place of Coulomb's sgn: the paper's Table 1, and what it does to a swing near rest
    Friction(friction::Arguments),
    /// Energies and forces to equations of motion, units checked, dimensionless groups, places of rest and modes
    Lagrange(lagrange::Arguments),
    /// The same swing against barriers of several materials: contact, rest time, and what is held fixed
    Materials(materials::Arguments),
    /// The design that rests soonest: the paper's genetic algorithm, what decides the optimum, fronts of several wishes
    Optimize(optimize::Arguments),
    /// Transition curves of a linear equation with periodic coefficients, such as Mathieu's: where rest is stable
    Stability(stability::Arguments),
    /// Claims of a publication from a file, each computed again, with a verdict
    Audit(audit::Arguments),
    /// Every number, equation, table and figure of the paper, computed again, with a verdict
    Paper(audit::PaperArguments),
    /// A proof beside a formula: the motion exists, and how far the formula is off, from both sides
    Certify(certify::Arguments),
    /// Check a certificate that `certify` wrote, in exact arithmetic
    Check(certify::CheckArguments),
    /// List the classical oscillators that `derive` knows by name
    Catalog(catalog::Arguments),
    /// Print the JSON Schema of a kind of document: every key with its meaning and unit
    Schema(schema::Arguments),
}

/// What every command takes.
#[derive(Args, Clone, Default)]
struct Common {
    /// What to print; without it what the name of --output ends in (.tex, .json, .html, .svg, .csv, .py), else text
    #[arg(long, value_parser = formats([Format::Svg, Format::Csv]))]
    format: Option<Format>,
    /// Write the result to this file instead of standard output; - for standard output
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draw the answer beside the truth to this SVG file (- for standard output)
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// Exit with code 3 if a verdict is worse than this relative error (verdicts use 0.01 without it)
    #[arg(long, value_name = "R", value_parser = positive, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Print results only, no notes and no progress
    #[arg(long)]
    quiet: bool,
    /// Give up after so many seconds
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true)]
    timeout: Option<f64>,
}

/// The option of a command without a verdict: its help is silent on it, and the command refuses it with the reason.
fn no_verdict(tolerance: clap::Arg) -> clap::Arg {
    tolerance.hide(true)
}

/// What a result is written in.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum Format {
    #[default]
    Text,
    Latex,
    Json,
    Csv,
    Svg,
    Html,
    Code(Language),
}

impl Format {
    /// Those of every command that has a result.
    const OF_ALL: [Self; 4] = [Self::Text, Self::Latex, Self::Json, Self::Html];

    /// All of them.
    fn all() -> impl Iterator<Item = Self> {
        let programs = Language::ALL.map(Self::Code);
        Self::OF_ALL.into_iter().chain([Self::Svg, Self::Csv]).chain(programs)
    }

    /// That of files whose names end so; none for `txt` and everything unknown.
    fn of_ending(ending: &str) -> Option<Self> {
        Some(match ending.to_ascii_lowercase().as_str() {
            "tex" => Self::Latex,
            "htm" => Self::Html,
            "rs" => Self::Code(Language::Rust),
            "c" => Self::Code(Language::C),
            "py" => Self::Code(Language::Python),
            "jl" => Self::Code(Language::Julia),
            "m" => Self::Code(Language::Matlab),
            name @ ("json" | "html" | "svg" | "csv") => Self::all().find(|format| format.name() == name)?,
            _ => return None,
        })
    }

    /// The name on the command line.
    fn name(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::Latex => "latex",
            Self::Json => "json",
            Self::Csv => "csv",
            Self::Svg => "svg",
            Self::Html => "html",
            Self::Code(language) => language.name(),
        }
    }
}

/// Reads a format. Help lists those of every command and these; a command refuses all others with the reason.
fn formats(listed: impl IntoIterator<Item = Format>) -> impl TypedValueParser<Value = Format> {
    let listed: Vec<Format> = Format::OF_ALL.into_iter().chain(listed).collect();
    let values = Format::all().map(|format| PossibleValue::new(format.name()).hide(!listed.contains(&format)));
    let unknown = || "no format of this name".to_owned();
    PossibleValuesParser::new(values)
        .try_map(move |name| Format::all().find(|format| format.name() == name).ok_or_else(unknown))
}

/// The option of a command that has no table.
fn without_table(format: clap::Arg) -> clap::Arg {
    format.value_parser(formats([Format::Svg]))
}

/// The option of a command that has neither a table nor a picture.
fn words_only(format: clap::Arg) -> clap::Arg {
    format.value_parser(formats([]))
}

/// The option of a command that writes programs.
fn with_programs(format: clap::Arg) -> clap::Arg {
    format.value_parser(formats(
        [Format::Svg].into_iter().chain(Language::ALL.map(Format::Code)),
    ))
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("expected a positive number".to_owned()),
    }
}

impl Common {
    /// The format asked for: by name, or by the ending of the file.
    fn format(&self) -> Format {
        let ending = || self.output.as_ref()?.extension()?.to_str();
        self.format
            .or_else(|| ending().and_then(Format::of_ending))
            .unwrap_or_default()
    }

    /// Whether the picture is asked for, beside the result or as it.
    fn draws(&self) -> bool {
        self.plot.is_some() || self.format() == Format::Svg
    }
}

/// A whole number that counts something from one.
fn count(text: &str) -> Result<u32, String> {
    match text.trim().parse() {
        Ok(count) if count > 0 => Ok(count),
        _ => Err("expected a whole number, 1 or more".to_owned()),
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

    /// A refusal with what else may be behind it.
    fn with_notes(self, notes: &[String]) -> Self {
        match self {
            Self::Refused(text) => Self::Refused(notes.iter().fold(text, |text, note| text + "\n  note: " + note)),
            Self::Usage(text) => Self::Usage(text),
        }
    }

    /// A refusal with the advice of the library.
    fn advised(error: &impl Display, advice: Option<Advice>) -> Self {
        Self::refused(error, advice.as_ref().map(in_flags))
    }
}

/// Advice of the library with its options as they are typed here.
fn in_flags(advice: &Advice) -> String {
    advice.spelt(|setting| match setting {
        Setting::Method(method) => format!("--method {}", method.name()),
        Setting::Order(order) => format!("--order {order}"),
        Setting::Degrees(degrees) => format!("--order {}", degrees.separated()),
        Setting::Amplitude(convention) => format!("--amplitude {}", convention.name()),
        Setting::Small(name) => format!("--small {name}"),
        Setting::Taylor => "--taylor DEGREE".to_owned(),
        Setting::About { coordinate, position } => format!("--about {coordinate}={position}"),
        Setting::Values => "--at".to_owned(),
        Setting::Resonance(driving, linear) => format!("--resonance {driving}:{linear}"),
        other => other.to_string(),
    })
}

/// Writes a result to where it is to go.
type Writer = Box<dyn FnOnce(&mut dyn std::io::Write) -> std::io::Result<()> + Send>;

/// The writer of a text.
fn whole(text: String) -> Writer {
    Box::new(move |to| to.write_all(text.as_bytes()))
}

/// What a command hands back.
struct Outcome {
    /// The result.
    result: Writer,
    /// Where a picture goes, and the picture or why there is none: the result stands without it.
    picture: Option<(PathBuf, Result<String, Failure>)>,
    /// Said on standard error.
    note: Option<String>,
    /// The verdict, where there is one.
    verdict: Option<Verdict>,
    /// Whether the work stopped before its end, so that this is only a part.
    partial: bool,
}

impl Command {
    /// What every command takes.
    fn common(&self) -> Common {
        match self {
            Self::Derive(arguments) => arguments.common.clone(),
            Self::Compare(arguments) => arguments.common.clone(),
            Self::Impact(arguments) => arguments.common.clone(),
            Self::Simulate(arguments) => arguments.common.clone(),
            Self::Response(arguments) => arguments.common.clone(),
            Self::Friction(arguments) => arguments.common.clone(),
            Self::Lagrange(arguments) => arguments.common.clone(),
            Self::Materials(arguments) => arguments.common.clone(),
            Self::Optimize(arguments) => arguments.common.clone(),
            Self::Stability(arguments) => arguments.common.clone(),
            Self::Audit(arguments) => arguments.common.clone(),
            Self::Paper(arguments) => arguments.common.clone(),
            Self::Certify(arguments) => arguments.common.clone(),
            Self::Check(arguments) => arguments.common.clone(),
            Self::Catalog(arguments) => arguments.common.clone(),
            Self::Schema(arguments) => arguments.common(),
        }
    }

    /// The file it reads, where it reads one.
    fn input(&self) -> Option<&Path> {
        match self {
            Self::Derive(arguments) => problem::path(&arguments.question.problem),
            Self::Certify(arguments) => problem::path(&arguments.question.problem),
            Self::Check(arguments) => Some(&arguments.file),
            Self::Compare(arguments) => problem::path(&arguments.problem),
            Self::Impact(arguments) => arguments.problem.as_deref().and_then(problem::path),
            Self::Simulate(arguments) => arguments.problem.as_deref().and_then(problem::path),
            Self::Response(arguments) => problem::path(&arguments.problem),
            Self::Lagrange(arguments) => arguments.file.as_deref(),
            Self::Materials(arguments) => arguments.file.as_deref(),
            Self::Optimize(arguments) => arguments.file.as_deref(),
            Self::Stability(arguments) => problem::path(&arguments.problem),
            Self::Audit(arguments) => Some(&arguments.file),
            Self::Paper(_) | Self::Friction(_) | Self::Catalog(_) | Self::Schema(_) => None,
        }
    }

    /// Refuses a format that it does not have, before any work is done for it.
    fn takes(&self, format: Format) -> Result<(), Failure> {
        let in_words = matches!(
            self,
            Self::Audit(_) | Self::Paper(_) | Self::Lagrange(_) | Self::Certify(_) | Self::Check(_) | Self::Catalog(_)
        );
        let refused = match (self, format) {
            (Self::Schema(_), _) => false,
            (Self::Derive(_) | Self::Compare(_) | Self::Impact(_), Format::Csv) => true,
            (Self::Derive(_), _) => false,
            (_, Format::Code(_)) => true,
            (_, Format::Svg | Format::Csv) => in_words,
            _ => false,
        };
        if refused { answer::no_such(format) } else { Ok(()) }
    }

    /// How long to wait for what there is, once the time is up. Only a simulation, a search, branches and an expansion have parts worth waiting
    /// for; to add up what a long one did takes a while.
    fn patience(&self) -> fn() -> Duration {
        match self {
            Self::Simulate(_) | Self::Response(_) | Self::Materials(_) | Self::Optimize(_) => {
                || Duration::from_secs(60)
            }
            Self::Derive(_) | Self::Certify(_) => derive::patience,
            _ => || Duration::ZERO,
        }
    }

    /// The time limit in seconds, where there is one.
    fn timeout(&self) -> Option<f64> {
        let limit = match self {
            Self::Check(_) => Some(certify::LONGEST_CHECK),
            _ => None,
        };
        self.common().timeout.or(limit)
    }

    /// Whether a verdict that fails is exit code 3 without `--tolerance`.
    fn is_judged(&self) -> bool {
        matches!(self, Self::Audit(_) | Self::Paper(_))
    }

    /// Does the work.
    fn run(&self) -> Result<Outcome, Failure> {
        match self {
            Self::Derive(arguments) => derive::run(arguments),
            Self::Compare(arguments) => compare::run(arguments),
            Self::Impact(arguments) => impact::run(arguments),
            Self::Simulate(arguments) => simulate::run(arguments),
            Self::Response(arguments) => response::run(arguments),
            Self::Friction(arguments) => friction::run(arguments),
            Self::Lagrange(arguments) => lagrange::run(arguments),
            Self::Materials(arguments) => materials::run(arguments),
            Self::Optimize(arguments) => optimize::run(arguments),
            Self::Stability(arguments) => stability::run(arguments),
            Self::Audit(arguments) => audit::run(arguments),
            Self::Paper(arguments) => audit::run_paper(arguments),
            Self::Certify(arguments) => certify::run(arguments),
            Self::Check(arguments) => certify::check(arguments),
            Self::Catalog(arguments) => catalog::run(arguments),
            Self::Schema(arguments) => schema::run(arguments),
        }
    }
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
    let common = command.common();
    let judged = common.tolerance.is_some() || command.is_judged();
    progress::QUIET.store(common.quiet, Ordering::Relaxed);
    match command
        .takes(common.format())
        .map_err(|failure| by_ending(failure, &common))
        .and_then(|()| files::check(&common, command.input()))
    {
        Err(Failure::Refused(message)) => return fail(1, &message),
        Err(Failure::Usage(message)) => return fail(2, &message),
        Ok(()) => {}
    }
    let timeout = command.timeout();
    let (outcome, in_vain) = within_limits(command, timeout);
    match (outcome, in_vain) {
        (Some(Some(Ok(outcome))), _) => finish(outcome, &common, judged),
        (Some(Some(Err(Failure::Refused(message)))), _) => fail(1, &message),
        (Some(Some(Err(Failure::Usage(message)))), _) => fail(2, &message),
        (None, Some((code, message))) => fail(code, &message),
        (Some(None), _) | (None, None) => fail(70, "internal error: please report the command and its input"),
    }
}

/// A refusal of a format, and who asked for it where it was the name of a file.
fn by_ending(failure: Failure, common: &Common) -> Failure {
    match failure {
        Failure::Usage(message) if common.format.is_none() => Failure::Usage(format!(
            "{message}\n  help: the name of --output asks for it; --format text writes text there"
        )),
        failure => failure,
    }
}

/// What came of the work; nothing where it broke.
type Worked = Option<Result<Outcome, Failure>>;

/// Exit code and message of work that ends without a result.
type InVain = (u8, String);

/// Does the work of a command until its end, an interrupt or the time limit: what came of it, where anything did, and what to say
/// where nothing did because it was ended.
fn within_limits(command: Command, timeout: Option<f64>) -> (Option<Worked>, Option<InVain>) {
    let patience = command.patience();
    let (sender, receiver) = channel();
    let interrupted = sender.clone();
    // The first interrupt asks for what there is, the second ends the program.
    let handler = ctrlc::set_handler(move || {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED.into());
        }
        let _ = interrupted.send(Message::Interrupt);
    });
    // Without a handler an interrupt just ends the program, as it would any other.
    drop(handler);
    // The work has a thread of its own so that a time limit can end it, wherever it is.
    let limit = timeout.map(|seconds| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
    // No time at all is up before the work begins, whichever of the two threads is run first.
    if limit.is_some_and(|limit| limit.is_zero()) {
        STOP.store(true, Ordering::Relaxed);
    }
    let started = Instant::now();
    let worker = std::thread::spawn(move || {
        let outcome = std::panic::catch_unwind(|| command.run());
        let _ = sender.send(Message::Done(outcome.ok()));
    });
    let first = match limit {
        None => receiver.recv().map_err(|_| RecvTimeoutError::Disconnected),
        Some(limit) => receiver.recv_timeout(limit),
    };
    // A whole result that comes too late is too late, however soon it was taken from the channel.
    let late = limit.is_some_and(|limit| started.elapsed() > limit) && patience().is_zero();
    let found = match first {
        Ok(Message::Done(outcome)) if !late => (Some(outcome), None),
        Ok(Message::Interrupt) => (
            wait_for_part(&receiver, patience()),
            Some((INTERRUPTED, "interrupted without a result".to_owned())),
        ),
        Ok(Message::Done(_)) | Err(_) => {
            let seconds = timeout.unwrap_or_default();
            let message =
                format!("stopped after {seconds} s without a result\n  help: lower the order, or raise --timeout");
            (wait_for_part(&receiver, patience()), Some((1, message)))
        }
    };
    if let (Some(None), _) | (None, None) = found {
        // It broke: its own words on standard error come first.
        let _ = worker.join();
    }
    found
}

/// Set by an interrupt or at the time limit; work that can hand back a part looks at it.
static STOP: AtomicBool = AtomicBool::new(false);

/// The exit code of a program ended by an interrupt, by the convention of shells.
const INTERRUPTED: u8 = 130;

/// What reaches the main thread.
enum Message {
    /// The work is done; nothing where it broke.
    Done(Worked),
    /// The user wants it to end.
    Interrupt,
}

/// Asks the work to hand back what it has, and waits a little for it; not at all for work that has no parts.
fn wait_for_part(receiver: &Receiver<Message>, patience: Duration) -> Option<Worked> {
    STOP.store(true, Ordering::Relaxed);
    if patience.is_zero() {
        return None;
    }
    let end = Instant::now() + patience;
    while let Ok(message) = receiver.recv_timeout(end.saturating_duration_since(Instant::now())) {
        if let Message::Done(outcome) = message {
            return Some(outcome);
        }
    }
    None
}

fn finish(outcome: Outcome, common: &Common, judged: bool) -> ExitCode {
    let mut no_picture = None;
    match outcome.picture {
        Some((path, Ok(picture))) => {
            if let Err(error) = files::write(Some(&path), whole(picture)) {
                return fail(1, &error);
            }
        }
        Some((_, Err(Failure::Refused(reason) | Failure::Usage(reason)))) => no_picture = Some(reason),
        None => {}
    }
    if let Some(note) = outcome.note.filter(|_| !common.quiet) {
        eprintln!("{}", printable(&note));
    }
    let written = files::write(common.output.as_deref(), outcome.result);
    if let (Ok(()), Some(reason)) = (&written, &no_picture) {
        let _ = writeln!(std::io::stderr(), "error: no picture: {}", printable(reason));
    }
    match written {
        Err(error) => fail(1, &error),
        Ok(()) if outcome.partial => ExitCode::from(4),
        Ok(()) if judged && outcome.verdict == Some(Verdict::Fail) => ExitCode::from(3),
        Ok(()) if no_picture.is_some() => ExitCode::from(1),
        Ok(()) => ExitCode::SUCCESS,
    }
}

fn fail(code: u8, message: &str) -> ExitCode {
    // A file that is quoted may hold anything.
    let _ = writeln!(std::io::stderr(), "error: {}", printable(message));
    ExitCode::from(code)
}

/// The text of a file, or of standard input for `-`; never more than a problem may have.
fn read(path: &Path) -> Result<String, Failure> {
    read_at_most(path, LARGEST_FILE)
}

/// The text of a file, or of standard input for `-`; one byte more than this length at most.
fn read_at_most(path: &Path, length: usize) -> Result<String, Failure> {
    let name = if path.as_os_str() == "-" {
        "standard input".to_owned()
    } else {
        path.display().to_string()
    };
    let failure = |error: std::io::Error| Failure::Refused(format!("cannot read {name}: {error}"));
    let limit = length as u64 + 1;
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

/// A document as text of several lines.
fn json_text(document: &impl Serialize) -> Result<String, Failure> {
    match serde_json::to_string_pretty(document) {
        // JSON leaves some characters as they are that steer a terminal; they are in strings alone.
        Ok(text) if text.chars().any(|letter| letter != '\n' && is_invisible(letter)) => {
            let escaped = text.chars().map(|letter| match letter != '\n' && is_invisible(letter) {
                true => format!("\\u{:04x}", u32::from(letter)),
                false => letter.to_string(),
            });
            Ok(escaped.collect::<String>() + "\n")
        }
        Ok(text) => Ok(text + "\n"),
        Err(error) => Err(Failure::Refused(error.to_string())),
    }
}

/// Refuses `--plot` where pictures were left out of the build.
#[cfg(not(feature = "plot"))]
fn no_pictures<T>() -> Result<T, Failure> {
    Err(Failure::Refused(
        "this build draws no pictures: build it with the feature `plot`".to_owned(),
    ))
}

//! Arguments -> calls -> printing: the only place that reads or prints. One file per command.
//!
//! In: the arguments, a problem file, standard input. Out: a result in the format asked for, a
//! picture, and the exit code. What is computed and what it says comes from the library; here
//! options are read, and refusals get the names of the options.
//!
//! Results go to standard output or the file of `--output`, all else to standard error. Exit codes:
//! 0 done, 1 refused or failed, 2 wrong usage, 3 verdict failed, 4 stopped before the end with a
//! partial result, 70 internal error.

mod absorber;
mod answer;
mod audit;
mod call;
mod catalog;
mod certify;
mod collect;
mod compare;
mod derive;
mod failure;
mod files;
mod fit;
mod format;
mod friction;
mod impact;
mod lagrange;
mod limits;
mod materials;
mod modes;
mod one_harmonic;
mod optimize;
mod orbits;
mod primary;
mod problem;
mod progress;
mod response;
mod schema;
mod session;
mod shard;
mod shell;
mod shortest;
mod simulate;
mod slow_equations;
mod stability;
mod suggestions;
mod trajectory;
mod walls;

pub use call::{CallFailure, CallResult, EquationRead, call, commands, read_equation};

use std::ffi::OsString;
use std::io::{Read as _, Write as _};
use std::panic::RefUnwindSafe;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::sync::mpsc::channel;
use std::time::Duration;

use crate::export::{is_invisible, latex, printable};
use crate::problem::LARGEST_FILE;
use crate::verify::{DEFAULT_TOLERANCE, Verdict};
use clap::builder::styling::{AnsiColor, Style};
use clap::{ArgMatches, Args};
use serde::Serialize;

use self::failure::{Failure, Reason, in_flags, values_of};
use self::format::{Format, Formats, format_parser};
use self::limits::{INTERRUPTED, Limits, Message, Watch, within_limits};
use self::session::Session;

/// The version, with the commit that it was built from where that is known.
const VERSION: &str = env!("LINDSTEDT_VERSION");

const AFTER_HELP: &str = "\
Without a command: lindstedt impact, the pendulum and barrier of J. E. Jam and A. A. Fard, Int. J. Aerospace
Sciences 1(2), 16-20 (2012), doi 10.5923/j.aerospace.20120102.02.

Exit codes: 0 done; 1 the problem was refused or failed; 2 wrong usage; 3 verdict failed (with --tolerance; audit and
paper always); 4 stopped before the end: what is printed is partial and says so.";

/// The commands, in the order of `--help`. A new one is a file with its arguments, documented by
/// their line in `--help`, and their [`Work`], and a row here.
static COMMANDS: [Command; 23] = [
    Command::new::<derive::DeriveArguments>("derive")
        .showing(include_str!("help/derive.txt"))
        .writing(Formats::Programs)
        .waiting(derive::grace_period),
    Command::new::<compare::CompareArguments>("compare").showing(include_str!("help/compare.txt")),
    Command::new::<impact::ImpactArguments>("impact")
        .showing(include_str!("help/impact.txt"))
        .writing(Formats::Pictures),
    Command::new::<simulate::SimulateArguments>("simulate")
        .showing(include_str!("help/simulate.txt"))
        .waiting(one_minute),
    Command::new::<response::ResponseArguments>("response")
        .showing(include_str!("help/response.txt"))
        .waiting(one_minute),
    Command::new::<absorber::AbsorberArguments>("absorber")
        .showing(include_str!("help/absorber.txt")),
    Command::new::<orbits::OrbitsArguments>("orbits").showing(include_str!("help/orbits.txt")),
    Command::new::<shortest::ShortestArguments>("shortest")
        .showing(include_str!("help/shortest.txt"))
        .writing(Formats::ProgramsAndTables)
        .waiting(one_minute)
        .judged(),
    Command::new::<fit::FitArguments>("fit")
        .showing(include_str!("help/fit.txt"))
        .writing(Formats::PicturesTablesAndProblems),
    Command::new::<friction::FrictionArguments>("friction")
        .showing(include_str!("help/friction.txt")),
    Command::new::<lagrange::LagrangeArguments>("lagrange")
        .showing(include_str!("help/lagrange.txt"))
        .writing(Formats::Words),
    Command::new::<materials::MaterialsArguments>("materials")
        .showing(include_str!("help/materials.txt"))
        .waiting(one_minute),
    Command::new::<optimize::OptimizeArguments>("optimize")
        .showing(include_str!("help/optimize.txt"))
        .waiting(one_minute),
    Command::new::<stability::StabilityArguments>("stability")
        .showing(include_str!("help/stability.txt")),
    Command::new::<audit::AuditArguments>("audit")
        .showing(include_str!("help/audit.txt"))
        .writing(Formats::Words)
        .judged(),
    Command::new::<audit::PaperArguments>("paper")
        .showing(include_str!("help/paper.txt"))
        .writing(Formats::Words)
        .judged(),
    Command::new::<collect::CollectArguments>("collect")
        .showing(include_str!("help/collect.txt"))
        .waiting(one_minute)
        .judged(),
    Command::new::<certify::CertifyArguments>("certify")
        .showing(include_str!("help/certify.txt"))
        .writing(Formats::Words)
        .waiting(derive::grace_period),
    Command::new::<certify::CheckArguments>("check")
        .showing(include_str!("help/check.txt"))
        .writing(Formats::Words)
        .limited(certify::LONGEST_CHECK),
    Command::new::<catalog::CatalogArguments>("catalog")
        .showing(include_str!("help/catalog.txt"))
        .writing(Formats::Words),
    Command::new::<schema::SchemaArguments>("schema")
        .showing(include_str!("help/schema.txt"))
        .writing(Formats::One),
    Command::new::<shell::CompletionsArguments>("completions").writing(Formats::One),
    Command::new::<shell::ManArguments>("man").writing(Formats::One),
];

/// The command that runs where none is named.
const USUAL: &str = "impact";

/// A row of [`COMMANDS`].
struct Command {
    /// The name on the command line.
    name: &'static str,
    /// The formats of its result.
    formats: Formats,
    /// The time to wait for a part of the result, once the time is up. Only a simulation, a search,
    /// branches and an expansion have parts worth waiting for; to add up what a long one did takes
    /// a while.
    patience: fn(&Session) -> Duration,
    /// The time limit in seconds where none is given.
    limit: Option<f64>,
    /// Whether a verdict that fails is exit code 3 without `--tolerance`.
    is_judged: bool,
    /// A command and its output, with which `--help` begins; empty where there is none.
    example: &'static str,
    /// Adds the arguments to the command line.
    augment: fn(clap::Command) -> clap::Command,
    /// Reads the arguments.
    read: fn(&ArgMatches) -> Result<Box<dyn Work>, clap::Error>,
}

/// The arguments of a command, and the work that they ask for.
trait Work: Send + RefUnwindSafe {
    /// The options that every command takes.
    fn common(&self) -> Common;

    /// The file that is read, where one is.
    fn input(&self) -> Option<&Path> {
        None
    }

    /// Does the work.
    fn run(&self) -> Result<Outcome, Failure>;
}

impl Command {
    /// The command with these arguments. It writes pictures and tables and has no parts to wait
    /// for, unless its row says otherwise.
    const fn new<A: Args + Work + 'static>(name: &'static str) -> Self {
        Self {
            name,
            formats: Formats::PicturesAndTables,
            patience: |_| Duration::ZERO,
            limit: None,
            is_judged: false,
            example: "",
            augment: A::augment_args,
            read: |matches| Ok(Box::new(A::from_arg_matches(matches)?)),
        }
    }

    /// The command with these formats.
    const fn writing(self, formats: Formats) -> Self {
        Self { formats, ..self }
    }

    /// The command with a result that may be a part.
    const fn waiting(self, patience: fn(&Session) -> Duration) -> Self {
        Self { patience, ..self }
    }

    /// The command with a time limit in seconds where none is given.
    const fn limited(self, seconds: f64) -> Self {
        Self { limit: Some(seconds), ..self }
    }

    /// The command with an exit code that tells its verdict.
    const fn judged(self) -> Self {
        Self { is_judged: true, ..self }
    }

    /// The command with an example of it and what it prints.
    const fn showing(self, example: &'static str) -> Self {
        Self { example, ..self }
    }

    /// The command as the parser of the command line knows it.
    fn parser(&self) -> clap::Command {
        let command = (self.augment)(clap::Command::new(self.name));
        let command = match self.example {
            "" => command,
            example => command.before_long_help(example.trim_end()),
        };
        match self.formats {
            Formats::One => command,
            formats => command
                .mut_arg("format", |format| format.value_parser(format_parser(formats.listed()))),
        }
    }

    /// The work that these arguments ask for.
    fn work(&self, matches: &ArgMatches) -> Result<Box<dyn Work>, clap::Error> {
        if matches!(matches.try_contains_id("shard"), Ok(true)) {
            session::current().begin_study(shard::words_of_study(&self.parser(), matches));
        }
        (self.read)(matches)
    }

    /// Refuses a format that the command does not have, before any work is done for it.
    fn check_format(&self, format: Format) -> Result<(), Failure> {
        let is_taken = matches!(self.formats, Formats::One)
            || Format::OF_ALL.contains(&format)
            || self.formats.listed().contains(&format);
        if is_taken { Ok(()) } else { answer::no_such(format) }
    }
}

/// A minute: the patience with work that is stopped and hands back a part.
fn one_minute(_: &Session) -> Duration {
    Duration::from_secs(60)
}

/// What every command takes.
#[derive(Args, Clone, Default)]
#[command(next_help_heading = "Result")]
struct Common {
    /// What to print; without it what the name of --output ends in (.tex, .json, .html, .svg, .csv,
    /// .py), else text
    #[arg(long, value_parser = format_parser([]))]
    format: Option<Format>,
    /// Write the result to this file instead of standard output; - for standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draw the answer beside the truth to this SVG file (- for standard output)
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// With --format latex: a whole document, which compiles as it is
    #[arg(long)]
    standalone: bool,
    /// Exit with code 3 if a verdict is worse than this relative error (verdicts use 0.01 without
    /// it)
    #[arg(long, value_name = "R", value_parser = positive, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Print results only, no notes and no progress
    #[arg(short, long)]
    quiet: bool,
    /// Give up after so many seconds
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true)]
    timeout: Option<f64>,
}

/// The option of a command without a verdict: its help is silent on it, and the command refuses it
/// with the reason.
fn no_verdict(tolerance: clap::Arg) -> clap::Arg {
    tolerance.hide(true)
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
        self.format.or_else(|| ending().and_then(Format::of_ending)).unwrap_or_default()
    }

    /// LaTeX as it is asked for: a whole document, or a part of one with what it needs.
    fn latex(&self, text: String) -> String {
        match self.standalone {
            true => latex::standalone(&text),
            false => format!("% needs {}\n{text}", latex::packages(&text)),
        }
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

/// Writes a result to where it is to go.
type Writer = Box<dyn FnOnce(&mut dyn std::io::Write) -> std::io::Result<()> + Send>;

/// The writer of a text.
fn text_writer(text: String) -> Writer {
    Box::new(move |to| to.write_all(text.as_bytes()))
}

/// The result of a command.
struct Outcome {
    /// The result.
    result: Writer,
    /// The path of a picture, and the picture or the reason why there is none: the result is valid
    /// without it.
    picture: Option<(PathBuf, Result<String, Failure>)>,
    /// Said on standard error.
    note: Option<String>,
    /// The verdict, where there is one.
    verdict: Option<Verdict>,
    /// Whether the work stopped before its end, so that this is only a part.
    partial: bool,
}

/// The command line as its parser knows it.
fn command_line() -> clap::Command {
    clap::Command::new("lindstedt")
        .version(VERSION)
        .about("Closed-form approximations of nonlinear vibrations, derived exactly and judged against the true motion")
        .max_term_width(100)
        .after_help(AFTER_HELP)
        .subcommands(COMMANDS.iter().map(Command::parser))
}

/// The row of the command that is asked for, and its arguments; an error is a message of the
/// parser, `--help` among them.
fn parse_command(words: Vec<OsString>) -> Result<(&'static Command, Box<dyn Work>), clap::Error> {
    let words = std::iter::once("lindstedt".into()).chain(words);
    let matches = command_line().try_get_matches_from(words)?;
    let (name, arguments) = matches.subcommand().unzip();
    let name = name.unwrap_or(USUAL);
    let Some(command) = COMMANDS.iter().find(|command| command.name == name) else {
        return Err(clap::Error::new(clap::error::ErrorKind::InvalidSubcommand));
    };
    let work = match arguments {
        Some(arguments) => command.work(arguments)?,
        None => command.work(&command.parser().try_get_matches_from([name])?)?,
    };
    Ok((command, work))
}

/// The command that these words ask for, and its work.
fn find_work(words: &[String]) -> Result<(&'static Command, Box<dyn Work>), Failure> {
    let named = words.first().and_then(|name| COMMANDS.iter().find(|row| row.name == name));
    let Some(command) = named else {
        return Err(Failure::Usage("no command of this name".to_owned()));
    };
    let parsed = command.parser().try_get_matches_from(words);
    let work = parsed.and_then(|matches| command.work(&matches)).map_err(|error| {
        let message = suggestions::with_what_is_meant(error).to_string();
        Failure::Usage(message.trim_start_matches("error: ").trim_end().to_owned())
    })?;
    Ok((command, work))
}

/// Runs the program with the words of the command line of this process.
pub fn run() -> ExitCode {
    ExitCode::from(main(std::env::args_os().skip(1).collect()))
}

/// Runs the program with these words, and returns its exit code.
pub fn main(words: Vec<OsString>) -> u8 {
    let session = Session::of_program(&words);
    let (command, work) = match parse_command(words) {
        Ok(asked) => asked,
        Err(error) => {
            // `--help` and `--version` are results and succeed; a closed pipe is no failure of
            // theirs.
            let code = u8::try_from(error.exit_code()).unwrap_or(2);
            let _ = suggestions::with_what_is_meant(error).print();
            return code;
        }
    };
    let common = work.common();
    let judged = common.tolerance.is_some() || command.is_judged;
    session.quiet.store(common.quiet, Ordering::Relaxed);
    match command
        .check_format(common.format())
        .map_err(|failure| by_ending(failure, &common))
        .and_then(|()| files::check(&common, work.input()))
    {
        Err(Failure::Refused(reason)) => return fail(1, &reason.text),
        Err(Failure::Usage(message)) => return fail(2, &message),
        Ok(()) => {}
    }
    let timeout = common.timeout.or(command.limit);
    // The first interrupt asks for what there is, the second ends the program.
    let (sender, receiver) = channel();
    let interrupted = sender.clone();
    let handler = ctrlc::set_handler(move || {
        if session.stop.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED.into());
        }
        let _ = interrupted.send(Message::Interrupt);
    });
    // Without a handler an interrupt just ends the program, as it would any other.
    drop(handler);
    let limits = Limits { timeout, patience: command.patience, watch: None };
    let (outcome, in_vain) = within_limits(work, session, (sender, receiver), limits);
    match (outcome, in_vain) {
        (Some(Some(Ok(outcome))), _) => finish(outcome, &common, judged),
        (Some(Some(Err(Failure::Refused(reason)))), _) => fail(1, &reason.text),
        (Some(Some(Err(Failure::Usage(message)))), _) => fail(2, &message),
        (None, Some((code, message))) => fail(code, &message),
        (Some(None), _) | (None, None) => {
            fail(70, "internal error: please report the command and its input")
        }
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

fn finish(outcome: Outcome, common: &Common, judged: bool) -> u8 {
    let mut no_picture = None;
    match outcome.picture {
        Some((path, Ok(picture))) => {
            if let Err(error) = files::write(Some(&path), text_writer(picture)) {
                return fail(1, &error);
            }
        }
        Some((_, Err(Failure::Refused(Reason { text, .. }) | Failure::Usage(text)))) => {
            no_picture = Some(text);
        }
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
        Ok(()) if outcome.partial => 4,
        Ok(()) if judged && outcome.verdict == Some(Verdict::Fail) => 3,
        Ok(()) if no_picture.is_some() => 1,
        Ok(()) => 0,
    }
}

fn fail(code: u8, message: &str) -> u8 {
    const STYLE: Style = AnsiColor::Red.on_default().bold();
    // A file that is quoted may hold anything.
    let _ = writeln!(anstream::stderr(), "{STYLE}error:{STYLE:#} {}", printable(message));
    code
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
    let failure = |error: std::io::Error| Failure::because(format!("cannot read {name}: {error}"));
    let limit = length as u64 + 1;
    let mut bytes = Vec::new();
    let given = match path.as_os_str() == "-" {
        true => session::current().take_input(),
        false => None,
    };
    if let Some(text) = given {
        session::current().keep_file(&text);
        return Ok(text);
    } else if path.as_os_str() == "-" && session::current().is_call() {
        return Ok(String::new());
    } else if path.as_os_str() == "-" {
        std::io::stdin().lock().take(limit).read_to_end(&mut bytes).map_err(failure)?;
    } else {
        std::fs::File::open(path)
            .map_err(failure)?
            .take(limit)
            .read_to_end(&mut bytes)
            .map_err(failure)?;
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        Failure::because(format!("{name} is not UTF-8 text: byte {place} belongs to no character"))
    })?;
    session::current().keep_file(&text);
    Ok(text)
}

fn tolerance(common: &Common) -> f64 {
    common.tolerance.unwrap_or(DEFAULT_TOLERANCE)
}

/// A document as text of several lines.
fn json_text(document: &impl Serialize) -> Result<String, Failure> {
    match serde_json::to_string_pretty(document) {
        // Of ASCII JSON escapes what steers a terminal, but for DEL: most documents need no second look.
        Ok(text) if text.is_ascii() && !text.contains('\u{7f}') => Ok(text + "\n"),
        // JSON leaves some characters as they are that steer a terminal; they are in strings alone.
        Ok(text) if text.chars().any(|letter| letter != '\n' && is_invisible(letter)) => {
            let escaped = text.chars().map(|letter| match letter != '\n' && is_invisible(letter) {
                true => format!("\\u{:04x}", u32::from(letter)),
                false => letter.to_string(),
            });
            Ok(escaped.collect::<String>() + "\n")
        }
        Ok(text) => Ok(text + "\n"),
        Err(error) => Err(error.into()),
    }
}

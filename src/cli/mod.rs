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
mod files;
mod fit;
mod friction;
mod impact;
mod lagrange;
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
use std::fmt::Display;
use std::io::{Read as _, Write as _};
use std::panic::RefUnwindSafe;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use crate::Symbol;
use crate::export::code::Language;
use crate::export::{is_invisible, latex, printable};
use crate::problem::LARGEST_FILE;
use crate::solution::{Advice, Setting};
use crate::verify::{DEFAULT_TOLERANCE, Verdict};
use clap::builder::styling::{AnsiColor, Style};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{ArgMatches, Args};
use lindstedt_expr::parallel::on_threads;
use serde::Serialize;

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

/// The formats of a command beside those of every command.
#[derive(Clone, Copy)]
enum Formats {
    /// Pictures and programs.
    Programs,
    /// Pictures, tables of comma-separated values and programs.
    ProgramsAndTables,
    /// Pictures.
    Pictures,
    /// Pictures and tables of comma-separated values.
    PicturesAndTables,
    /// Pictures, tables of comma-separated values and problem files.
    PicturesTablesAndProblems,
    /// No formats beside those of every result.
    Words,
    /// A single format, whatever the file is called: there is no `--format`.
    One,
}

impl Formats {
    /// The formats that the help lists beside those of every command.
    fn listed(self) -> Vec<Format> {
        match self {
            Self::Programs | Self::ProgramsAndTables => {
                let mut formats = vec![Format::Svg];
                formats.extend(matches!(self, Self::ProgramsAndTables).then_some(Format::Csv));
                formats.extend(Language::ALL.map(Format::Code));
                formats
            }
            Self::Pictures => vec![Format::Svg],
            Self::PicturesAndTables => vec![Format::Svg, Format::Csv],
            Self::PicturesTablesAndProblems => vec![Format::Svg, Format::Csv, Format::Toml],
            Self::Words | Self::One => vec![],
        }
    }
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

/// The format of a result.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum Format {
    #[default]
    Text,
    Latex,
    Json,
    Csv,
    Svg,
    Html,
    Toml,
    Code(Language),
}

impl Format {
    /// The formats of every command that has a result.
    const OF_ALL: [Self; 4] = [Self::Text, Self::Latex, Self::Json, Self::Html];

    /// All of them.
    fn all() -> impl Iterator<Item = Self> {
        let programs = Language::ALL.map(Self::Code);
        Self::OF_ALL.into_iter().chain([Self::Svg, Self::Csv, Self::Toml]).chain(programs)
    }

    /// What the names of its files end in beside the name of the format itself.
    fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Text => &["txt"],
            Self::Latex => &["tex"],
            Self::Html => &["htm"],
            Self::Code(Language::Rust) => &["rs"],
            Self::Code(Language::Python) => &["py"],
            Self::Code(Language::Julia) => &["jl"],
            Self::Code(Language::Matlab) => &["m"],
            Self::Json | Self::Csv | Self::Svg | Self::Toml | Self::Code(Language::C) => &[],
        }
    }

    /// The format of files whose names end so; `None` for an unknown one.
    fn of_ending(ending: &str) -> Option<Self> {
        let ending = ending.to_ascii_lowercase();
        // A file called `x.rust` or `x.latex` is none of ours.
        let is_ending = |format: &Self| match format.endings() {
            [] => format.name() == ending,
            endings => {
                endings.contains(&ending.as_str()) || *format == Self::Html && ending == "html"
            }
        };
        Self::all().find(is_ending)
    }

    /// Advice for a file with this ending, of a kind that is not written here.
    fn instead_of(ending: &str) -> Option<&'static str> {
        Some(match ending.to_ascii_lowercase().as_str() {
            "pdf" => "write .html and print it, or .tex",
            "png" | "jpg" | "jpeg" => "write .svg, which converts to it",
            "xls" | "xlsx" | "ods" => "write .csv",
            "doc" | "docx" => "write .html or .tex",
            "nb" | "ipynb" => "write .py or .json",
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
            Self::Toml => "toml",
            Self::Code(language) => language.name(),
        }
    }
}

/// Reads a format. Help lists those of every command and these; a command refuses all others with
/// the reason.
fn format_parser(
    listed: impl IntoIterator<Item = Format>,
) -> impl TypedValueParser<Value = Format> {
    let listed: Vec<Format> = Format::OF_ALL.into_iter().chain(listed).collect();
    let values = Format::all().map(|format| {
        let endings = format.endings().iter().copied();
        PossibleValue::new(format.name()).aliases(endings).hide(!listed.contains(&format))
    });
    let unknown = || "no format of this name".to_owned();
    PossibleValuesParser::new(values).try_map(move |name| {
        let is_meant =
            |format: &Format| format.name() == name || format.endings().contains(&name.as_str());
        Format::all().find(is_meant).ok_or_else(unknown)
    })
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

/// Why a command ends without its result.
enum Failure {
    /// Exit code 1: the problem was refused, or something failed.
    Refused(Reason),
    /// Exit code 2.
    Usage(String),
}

/// The reason of a refusal.
#[derive(Debug, PartialEq)]
struct Reason {
    /// The whole message, with its help and its notes.
    text: String,
    /// The part of the program that refused, by the name of its error, `oscillator` say; `command`
    /// for what belongs to no part.
    kind: String,
    /// The term of the equation that is to blame, as it was typed.
    term: Option<String>,
}

/// A refusal that knows no way forward.
impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::refused(&error, None)
    }
}

impl Failure {
    /// A refusal with its way forward.
    fn refused(error: &impl Display, help: Option<String>) -> Self {
        let text = match help {
            Some(help) => format!("{error}\n  help: {help}"),
            None => error.to_string(),
        };
        Self::Refused(Reason { text, kind: kind_of(error), term: None })
    }

    /// A refusal for this reason, by the command itself.
    fn because(text: impl Into<String>) -> Self {
        Self::refused(&text.into(), None)
    }

    /// A refusal by the part of the program that this error belongs to.
    fn of_kind<E>(self, error: &E) -> Self {
        match self {
            Self::Refused(reason) => Self::Refused(Reason { kind: kind_of(error), ..reason }),
            usage => usage,
        }
    }

    /// A refusal with the term that is to blame.
    fn naming(self, term: Option<&str>) -> Self {
        match self {
            Self::Refused(reason) => {
                Self::Refused(Reason { term: term.map(str::to_owned), ..reason })
            }
            usage => usage,
        }
    }

    /// The failure of one of many, after the name of that one.
    fn within(self, name: &str) -> Self {
        match self {
            Self::Refused(reason) => {
                Self::Refused(Reason { text: format!("{name}: {}", reason.text), ..reason })
            }
            Self::Usage(text) => Self::because(format!("{name}: {text}")),
        }
    }

    /// A refusal with what else may be behind it.
    fn with_notes(self, notes: &[String]) -> Self {
        match self {
            Self::Refused(reason) => {
                let added = |text: String, note: &String| text + "\n  note: " + note;
                Self::Refused(Reason { text: notes.iter().fold(reason.text, added), ..reason })
            }
            Self::Usage(text) => Self::Usage(text),
        }
    }

    /// A refusal with the advice of the library.
    fn with_advice(error: &impl Display, advice: Option<Advice>) -> Self {
        Self::refused(error, advice.as_ref().map(in_flags))
    }
}

/// The name of an error without `Error`, in the spelling of the formats: `oscillator`.
fn kind_of<E>(_: &E) -> String {
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
fn in_flags(advice: &Advice) -> String {
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
fn values_of(names: &[Symbol]) -> String {
    let values: Vec<String> = names.iter().map(|name| format!("{name}=VALUE")).collect();
    format!("--at {}", values.join(","))
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

/// The result of the work; `None` if it panicked.
type Worked = Option<Result<Outcome, Failure>>;

/// Exit code and message of work that ends without a result.
type InVain = (u8, String);

/// Does work until its end, an interrupt or the time limit: what came of it, where anything did,
/// and what to say where nothing did because it was ended.
fn within_limits(
    work: Box<dyn Work>,
    session: &'static Session,
    (sender, receiver): (Sender<Message>, Receiver<Message>),
    Limits { timeout, patience, watch }: Limits,
) -> (Option<Worked>, Option<InVain>) {
    // The work has a thread of its own so that a time limit can end it, wherever it is.
    let limit =
        timeout.map(|seconds| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
    // No time at all is up before the work begins, whichever of the two threads is run first.
    if limit.is_some_and(|limit| limit.is_zero()) {
        session.stop.store(true, Ordering::Relaxed);
    }
    let started = Instant::now();
    let is_forked = is_forked();
    let worker = std::thread::spawn(move || {
        let run = move || {
            session.enter();
            std::panic::catch_unwind(|| work.run())
        };
        let outcome = match is_forked {
            true => on_threads(0, run),
            false => run(),
        };
        let _ = sender.send(Message::Done(outcome.ok()));
    });
    // A caller that ends a work has no use for a part of it.
    let after_interrupt: fn(&Session) -> Duration = match watch {
        Some(_) => |_| Duration::ZERO,
        None => patience,
    };
    let first = match watch {
        None => receive(&receiver, limit),
        Some(watch) => loop {
            let left = limit.map(|limit| limit.saturating_sub(started.elapsed()));
            let wait = left.unwrap_or(EVERY).min(EVERY);
            match receiver.recv_timeout(wait) {
                Err(RecvTimeoutError::Timeout) if left.is_none_or(|left| left > EVERY) => {
                    let (done, all) = session.progress.read();
                    if !watch(done, all) {
                        session.abandon();
                        break Ok(Message::Interrupt);
                    }
                }
                other => break other,
            }
        },
    };
    // A whole result that comes too late is too late, however soon it was taken from the channel.
    let late = limit.is_some_and(|limit| started.elapsed() > limit) && patience(session).is_zero();
    let found = match first {
        Ok(Message::Done(outcome)) if !late => (Some(outcome), None),
        Ok(Message::Interrupt) => (
            wait_for_part(&receiver, session, after_interrupt(session)),
            Some((INTERRUPTED, "interrupted without a result".to_owned())),
        ),
        Ok(Message::Done(_)) | Err(_) => {
            let seconds = timeout.unwrap_or_default();
            let message = format!(
                "stopped after {seconds} s without a result\n  help: lower the order, or raise --timeout"
            );
            (wait_for_part(&receiver, session, patience(session)), Some((1, message)))
        }
    };
    if let (Some(None), _) | (None, None) = found {
        // It broke: its own words on standard error come first.
        let _ = worker.join();
    }
    found
}

/// Whether this process is the child of one that had run a command before it was forked. The threads
/// of the parent's pool are not in the child, which would wait for them for ever: it takes new ones.
fn is_forked() -> bool {
    static FIRST: AtomicU32 = AtomicU32::new(0);
    let own = std::process::id();
    let first = FIRST.compare_exchange(0, own, Ordering::Relaxed, Ordering::Relaxed);
    first.is_err_and(|first| first != own)
}

/// The limits of a work.
struct Limits<'a> {
    /// The time limit in seconds.
    timeout: Option<f64>,
    /// The time to wait for a part of the result.
    patience: fn(&Session) -> Duration,
    /// Is told the progress again and again, and says whether to go on.
    watch: Option<Watch<'a>>,
}

/// Takes the parts done and all of them, and returns whether the work is to go on.
type Watch<'a> = &'a mut dyn FnMut(u64, u64) -> bool;

/// The time between two looks at the progress of a call.
const EVERY: Duration = Duration::from_millis(50);

/// The next message, within the limit.
fn receive(
    receiver: &Receiver<Message>,
    limit: Option<Duration>,
) -> Result<Message, RecvTimeoutError> {
    match limit {
        None => receiver.recv().map_err(|_| RecvTimeoutError::Disconnected),
        Some(limit) => receiver.recv_timeout(limit),
    }
}

/// The exit code of a program ended by an interrupt, by the convention of shells.
const INTERRUPTED: u8 = 130;

/// A message to the main thread.
enum Message {
    /// The work is done; nothing where it broke.
    Done(Worked),
    /// The user wants it to end.
    Interrupt,
}

/// Asks the work to hand back what it has, and waits a little for it; not at all for work that has
/// no parts.
fn wait_for_part(
    receiver: &Receiver<Message>,
    session: &Session,
    patience: Duration,
) -> Option<Worked> {
    session.stop.store(true, Ordering::Relaxed);
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

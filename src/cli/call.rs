//! A command inside another process: its words go in, its result comes out as text, and nothing is
//! printed.

use std::sync::mpsc::channel;

use super::session::Session;
use super::{
    COMMANDS, Command, Failure, INTERRUPTED, Limits, Outcome, Reason, Watch, Work, by_ending,
    files, find_work, within_limits,
};
use crate::{Oscillator, Verdict};

/// The result of a command.
#[derive(Clone, Debug, PartialEq)]
pub struct CallResult {
    /// The result in the format asked for; empty where `--output` took it.
    pub text: String,
    /// Notes and warnings on it, each a sentence or a few.
    pub notes: Vec<String>,
    /// The result in the other formats that it has, each with its name, where the work took so long
    /// that it should not be done again for them.
    pub forms: Vec<(&'static str, String)>,
    /// Whether the verdict is a pass; `None` where there is no verdict.
    pub passed: Option<bool>,
    /// Whether the work stopped before its end, so that this is only a part.
    pub partial: bool,
}

/// The failure of a command.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct CallFailure {
    /// The exit code that the program has for it: 1 refused, 2 wrong usage, 70 an internal error,
    /// 130 interrupted.
    pub code: u8,
    /// The part of the program that refused, by the name of its error: `oscillator`, `refusal`,
    /// `problem`; `usage` for code 2, `command` for what belongs to no part.
    pub kind: String,
    /// The message as the program prints it, with its help and its notes.
    pub message: String,
    /// The term of the equation that is to blame, as it was typed.
    pub term: Option<String>,
}

/// Runs a command with its arguments, `["derive", "pendulum", "--format", "json"]`, and returns its
/// result as text. The text `input` stands for the file `-`. The work is done by a thread of its
/// own; every 50 ms `watch` is told the parts done and all of them, and returns whether to go on.
/// Calls on several threads do not meet.
///
/// ```
/// let words = ["derive", "pendulum", "--order", "2"].map(str::to_owned);
/// let result = lindstedt::cli::call(words.to_vec(), None, &mut |_, _| true)?;
/// assert!(result.text.contains("omega^2 = 1 - A^2/8"));
///
/// let words = ["derive", "x'' + 2*zeta*x' + sin(x) = 0", "--method", "lindstedt-poincare"];
/// let failure = lindstedt::cli::call(words.map(str::to_owned).to_vec(), None, &mut |_, _| true);
/// assert_eq!(failure.unwrap_err().term.as_deref(), Some("2*zeta*x'"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// The refusal, wrong usage, or an interrupt by `watch`. Work that does not look at interrupts, or
/// is over its time limit, is left behind on its thread until it ends.
pub fn call(
    words: Vec<String>,
    input: Option<String>,
    watch: Watch,
) -> Result<CallResult, CallFailure> {
    let session = Session::of_call(words, input);
    session.enter();
    let work = find_work(&session.words()).and_then(|(command, work)| {
        prepare(command, work.as_ref())?;
        Ok((command, work))
    });
    let (command, work) = match work {
        Ok(asked) => asked,
        Err(failure) => {
            session.end();
            return Err(failure.into());
        }
    };
    let output = work.common().output;
    let limits = Limits {
        timeout: work.common().timeout.or(command.limit),
        patience: command.patience,
        watch: Some(watch),
    };
    let (worked, in_vain) = within_limits(work, session, channel(), limits);
    let notes = session.take_notes();
    let result = match (worked, in_vain) {
        (Some(Some(Ok(outcome))), _) => {
            let result = finish(outcome, output.as_deref(), notes).map_err(CallFailure::from);
            result.map(|result| CallResult { forms: session.take_forms(), ..result })
        }
        (Some(Some(Err(failure))), _) => Err(failure.into()),
        // Work that is left behind still looks at its session.
        (None, Some((code, message))) => {
            let kind = if code == INTERRUPTED { "interrupted" } else { "timeout" };
            return Err(CallFailure { code, kind: kind.to_owned(), message, term: None });
        }
        (Some(None), _) | (None, None) => Err(CallFailure {
            code: 70,
            kind: "internal".to_owned(),
            message: "internal error: please report the command and its input".to_owned(),
            term: None,
        }),
    };
    session.end();
    result
}

/// Refuses what no work is done for.
fn prepare(command: &Command, work: &dyn Work) -> Result<(), Failure> {
    let common = work.common();
    command
        .check_format(common.format())
        .map_err(|failure| by_ending(failure, &common))
        .and_then(|()| files::check(&common, work.input()))
}

/// The result as text, or in its file.
fn finish(
    outcome: Outcome,
    output: Option<&std::path::Path>,
    mut notes: Vec<String>,
) -> Result<CallResult, Failure> {
    match outcome.picture {
        Some((path, Ok(picture))) => {
            files::write(Some(&path), super::text_writer(picture)).map_err(Failure::because)?
        }
        Some((_, Err(Failure::Refused(Reason { text, .. }) | Failure::Usage(text)))) => {
            notes.push(format!("no picture: {text}"));
        }
        None => {}
    }
    notes.extend(outcome.note);
    let mut bytes = Vec::new();
    match output.filter(|path| !files::is_standard(path)) {
        Some(path) => files::write(Some(path), outcome.result).map_err(Failure::because)?,
        None => (outcome.result)(&mut bytes)?,
    }
    Ok(CallResult {
        text: String::from_utf8(bytes)?,
        notes,
        forms: Vec::new(),
        passed: outcome.verdict.map(|verdict| verdict == Verdict::Pass),
        partial: outcome.partial,
    })
}

impl From<Failure> for CallFailure {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Refused(Reason { text, kind, term }) => {
                Self { code: 1, kind, message: text, term }
            }
            Failure::Usage(text) => {
                Self { code: 2, kind: "usage".to_owned(), message: text, term: None }
            }
        }
    }
}

/// An equation as it is read.
#[derive(Clone, Debug, PartialEq)]
pub struct EquationRead {
    /// The equation of motion in the grammar of the program.
    pub equation: String,
    /// The coordinate.
    pub coordinate: String,
    /// The parameters, in alphabetical order.
    pub parameters: Vec<String>,
}

/// Reads the equation of a problem: an equation, a name of the catalogue, or the path of a file.
/// The text `input` stands for the file `-`.
///
/// # Errors
/// The problem has no equation, or its equation is that of no oscillator.
pub fn read_equation(problem: &str, input: Option<String>) -> Result<EquationRead, CallFailure> {
    let session = Session::of_call(vec![problem.to_owned()], input);
    session.enter();
    let read = super::problem::problem(problem).and_then(|problem| {
        let equation = problem.equation.ok_or_else(|| {
            Failure::because("the file has no `equation`, so that there is no oscillator")
        })?;
        let oscillator = Oscillator::parse(&equation)
            .map_err(|error| Failure::with_advice(&error, error.help()).naming(error.term()))?;
        Ok((equation, oscillator))
    });
    session.end();
    let (equation, oscillator) = read?;
    Ok(EquationRead {
        equation,
        coordinate: oscillator.coordinate.to_string(),
        parameters: oscillator.parameters.iter().map(ToString::to_string).collect(),
    })
}

/// Returns the commands with their arguments as JSON, for those who write a front end: a list of
/// `{name, about, arguments}`, and of each argument its name, what it takes and its help.
///
/// ```
/// let commands: serde_json::Value = serde_json::from_str(&lindstedt::cli::commands())?;
/// assert_eq!(commands[0]["name"], "derive");
/// assert_eq!(commands[0]["arguments"][0]["name"], "problem");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn commands() -> String {
    let described = |command: &Command| {
        let parser = command.parser();
        let arguments: Vec<serde_json::Value> = parser.get_arguments().map(argument).collect();
        let about = parser.get_about().map(ToString::to_string);
        serde_json::json!({ "name": command.name, "about": about, "arguments": arguments })
    };
    serde_json::Value::Array(COMMANDS.iter().map(described).collect()).to_string()
}

/// An argument as JSON.
fn argument(argument: &clap::Arg) -> serde_json::Value {
    let takes = match argument.get_action() {
        clap::ArgAction::SetTrue => None,
        _ => argument.get_value_names().and_then(|names| names.first()).map(ToString::to_string),
    };
    let choices: Vec<String> =
        argument.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect();
    serde_json::json!({
        "name": argument.get_long().unwrap_or(argument.get_id().as_str()),
        "positional": argument.is_positional(),
        "required": argument.is_required_set(),
        "repeatable": matches!(argument.get_action(), clap::ArgAction::Append),
        "hidden": argument.is_hide_set(),
        "takes": takes,
        "choices": choices,
        "help": argument.get_help().map(ToString::to_string),
    })
}

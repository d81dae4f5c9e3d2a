//! The option `--shard I/N`: only every N-th point of a study, a line of JSON each.
//!
//! A command that can be split asks here for the rows of its points: those of `lindstedt collect`,
//! where that runs it again with rows that are known, or none, and it computes them. With `--shard`
//! it hands over how a point is computed, and the lines are its result.

use std::io::Write as _;

use clap::parser::ValueSource;
use clap::{ArgMatches, Args};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use crate::export::json::JsonError;
use crate::export::json::shard::{NoShard, Shard, StudyDocument};

use super::files::is_standard;
use super::progress::PartsBar;
use super::{Common, Failure, Format, Outcome, VERSION, session, text_writer};

/// The option of a command that can be split.
#[derive(Args, Clone, Copy)]
pub(super) struct ShardArguments {
    /// Do only every N-th point, from the I-th on (3/64), and write a line of JSON for each;
    /// lindstedt collect joins the lines of all N shards
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub(super) shard: Option<Shard>,
}

fn shard(text: &str) -> Result<Shard, String> {
    text.parse().map_err(|error: NoShard| error.to_string())
}

/// The points of a study.
pub(super) struct Points<'a> {
    /// Their number.
    pub(super) total: usize,
    /// The number of points that are computed together, after which their lines are written.
    pub(super) together: usize,
    /// The template of the bar.
    pub(super) bar: &'a str,
    /// Returns the values of what varies, at the point of this index.
    pub(super) inputs: &'a dyn Fn(usize) -> Map<String, Value>,
}

/// The words of a command by which its study is known: what says how the result is handed on, and
/// how fast it comes about, is left out.
pub(super) fn words_of_study(parser: &clap::Command, matches: &ArgMatches) -> Vec<String> {
    const LEFT_OUT: [&str; 10] = [
        "format",
        "output",
        "plot",
        "standalone",
        "quiet",
        "timeout",
        "jobs",
        "shard",
        "record",
        "resume",
    ];
    let mut words = vec![parser.get_name().to_owned()];
    let mut places = Vec::new();
    for argument in parser.get_arguments() {
        let id = argument.get_id().as_str();
        let is_given = matches.value_source(id) == Some(ValueSource::CommandLine);
        if !is_given || LEFT_OUT.contains(&id) {
            continue;
        }
        let raw = matches.get_raw(id).into_iter().flatten();
        let values = raw.map(|value| value.to_string_lossy().into_owned());
        match argument.get_long() {
            None => places.extend(values),
            Some(long) if argument.get_action().takes_values() => {
                words.extend(values.map(|value| format!("--{long}={value}")));
            }
            Some(long) => words.push(format!("--{long}")),
        }
    }
    if !places.is_empty() {
        words.push("--".to_owned());
        words.extend(places);
    }
    words
}

/// Refuses what does not go with `--shard`, before any work is done.
pub(super) fn check(common: &Common) -> Result<(), Failure> {
    let is_lines = match common.format() {
        Format::Text => common.format.is_none(),
        format => format == Format::Json,
    };
    if !is_lines || common.draws() {
        return Err(Failure::Usage(
            "--shard writes lines of JSON: give the format and the picture to `lindstedt collect`"
                .to_owned(),
        ));
    }
    Ok(())
}

/// The rows of all points, where `lindstedt collect` knows them.
///
/// # Errors
/// The rows are those of another number of points, or hold something else.
pub(super) fn known<R: DeserializeOwned>(total: usize) -> Result<Option<Vec<R>>, Failure> {
    let Some(rows) = session::current().take_rows() else {
        return Ok(None);
    };
    if rows.len() != total {
        return Err(Failure::because(format!(
            "the lines are those of {} points, and the command has {total}",
            rows.len()
        )));
    }
    let read = |(index, row): (usize, Map<String, Value>)| {
        serde_json::from_value(Value::Object(row)).map_err(|_| unreadable(index))
    };
    rows.into_iter().enumerate().map(read).collect::<Result<_, _>>().map(Some)
}

/// The failure of a row that is none of the command.
pub(super) fn unreadable(index: usize) -> Failure {
    Failure::because(format!("the row of point {index} is none of this command"))
}

/// Computes the points of a shard and writes their lines: on standard output of the program as they
/// are done, else all together. `follow` takes indices and gives the row of each, `None` for a point
/// that an interrupt kept from its end.
///
/// # Errors
/// The errors of `follow`, and a row that JSON cannot hold.
pub(super) fn write<R: Serialize + DeserializeOwned>(
    shard: Shard,
    common: &Common,
    points: &Points,
    follow: impl Fn(&[usize]) -> Result<Vec<Option<R>>, Failure>,
) -> Result<Outcome, Failure> {
    check(common)?;
    let session = session::current();
    let (command, file) = session.study();
    let study = StudyDocument::new(VERSION, command, file, points.total, shard);
    let indices: Vec<usize> = shard.indices(points.total).collect();
    let streams = !session.is_call() && common.output.as_deref().is_none_or(is_standard);
    let (mut lines, mut done) = (study.line()?, 0);
    let bar = PartsBar::new(indices.len(), points.bar);
    for block in indices.chunks(points.together.max(1)) {
        if session::interrupt().is_requested() {
            break;
        }
        let rows = follow(block)?;
        bar.advance(block.len());
        for (index, row) in block.iter().zip(rows) {
            let Some(row) = row else { continue };
            let row = written(&row).map_err(|_| {
                Failure::because(format!("point {index} has a number that JSON cannot hold"))
            })?;
            lines += &study.point(*index, (points.inputs)(*index), row).line()?;
            done += 1;
        }
        if streams && !hand_on(&mut lines)? {
            break;
        }
    }
    bar.finish();
    if streams {
        hand_on(&mut lines)?;
    }
    let partial = done < indices.len();
    Ok(Outcome {
        result: text_writer(lines),
        picture: None,
        note: partial.then(|| {
            let all = indices.len();
            format!("warning: stopped early, what there is is kept: {done} of {all} points")
        }),
        verdict: None,
        partial,
    })
}

/// A row as an object that reads back as the same.
fn written<R: Serialize + DeserializeOwned>(row: &R) -> Result<Map<String, Value>, JsonError> {
    let text = serde_json::to_string(row)?;
    let again: R = serde_json::from_str(&text)?;
    let same = serde_json::to_string(&again)? == text;
    serde_json::from_str(if same { &text } else { "" }).map_err(JsonError::from)
}

/// Prints whole lines; false where nobody reads them.
fn hand_on(lines: &mut String) -> Result<bool, Failure> {
    let mut output = std::io::stdout().lock();
    let printed = output.write_all(lines.as_bytes()).and_then(|()| output.flush());
    lines.clear();
    match printed {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(Failure::because(format!("standard output: {error}"))),
    }
}

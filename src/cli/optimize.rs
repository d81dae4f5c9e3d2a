//! `lindstedt optimize [FILE]`.

use std::fs::{File, OpenOptions};
use std::io::{Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use crate::export::json::optimization::{Run, read_record, record_head, record_line};
use crate::export::json::shard::Shard;
use crate::export::{json, optimization};
use crate::genetic::SearchError;
use crate::optimize::{
    OptimizationProblem, OptimizeError, SearchRun, Study, StudyObserver, optimize, optimize_on,
    search_runs,
};
use crate::problem::Problem;
use crate::report;
use clap::Args;
use lindstedt_expr::parallel::on_threads;

use super::answer::{Answer, no_such};
use super::files::{is_same_file, is_standard, width};
use super::problem::from_file;
use super::progress::PartsBar;
use super::session;
use super::shard::{self, Points, ShardArguments};
use super::{Common, Failure, Format, Outcome, Work, count, json_text, read_at_most};

/// The design that rests soonest: the paper's genetic algorithm, what decides the optimum, fronts
/// of several wishes
#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
pub struct OptimizeArguments {
    /// A TOML file, or - for standard input; without it the paper's study: its Table 4 searched for
    /// the least rest time
    pub file: Option<PathBuf>,
    /// Seed of all random numbers, in place of that of the file
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// How often to run the search, in place of the number in the file
    #[arg(long, value_name = "N", value_parser = count)]
    runs: Option<u32>,
    /// Threads; all cores without it. The result is the same for any number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Stop after so many evaluations, shared evenly by the runs, or after so many seconds (30s)
    /// with the runs that are done
    #[arg(long, value_name = "N|SECONDSs", value_parser = budget)]
    budget: Option<SearchBudget>,
    /// Write every run to this file as soon as it is done, a line of JSON each
    #[arg(long, value_name = "FILE.jsonl")]
    record: Option<PathBuf>,
    /// Take the runs of this record over, do the missing ones, and add them to it: the result is
    /// the same as in one go
    #[arg(long, value_name = "FILE.jsonl")]
    resume: Option<PathBuf>,
    #[command(flatten)]
    shard: ShardArguments,
    #[command(flatten)]
    pub common: Common,
}

/// The budget of a search.
#[derive(Clone, Copy, PartialEq)]
enum SearchBudget {
    Evaluations(usize),
    Time(Duration),
}

fn budget(text: &str) -> Result<SearchBudget, String> {
    let seconds = |text: &str| {
        let seconds = text.parse::<f64>().ok().filter(|seconds| *seconds > 0.0)?;
        Duration::try_from_secs_f64(seconds).ok()
    };
    match (text.strip_suffix('s'), text.parse::<usize>()) {
        (None, Ok(evaluations)) if evaluations > 0 => Ok(SearchBudget::Evaluations(evaluations)),
        (Some(text), _) if seconds(text).is_some() => {
            Ok(SearchBudget::Time(seconds(text).unwrap_or_default()))
        }
        _ => Err("expected a number of evaluations (50000), or of seconds (30s)".to_owned()),
    }
}

impl Work for OptimizeArguments {
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

fn run(arguments: &OptimizeArguments) -> Result<Outcome, Failure> {
    let problem = match &arguments.file {
        None => Problem::default(),
        Some(path) => from_file(path)?,
    };
    let common = &arguments.common;
    if common.tolerance.is_some() {
        return Err(Failure::Usage(
            "--tolerance belongs to a verdict, and a search has none: leave it out".to_owned(),
        ));
    }
    let mut question =
        problem.optimize().map_err(|error| Failure::refused(&error, error.help()))?;
    question.seed = arguments.seed.unwrap_or(question.seed);
    question.runs = arguments.runs.map_or(question.runs, |runs| runs as usize);
    if let Some(SearchBudget::Evaluations(evaluations)) = arguments.budget {
        question.genetic.budget = Some(evaluations / question.runs.max(1));
    }
    let deadline = match arguments.budget {
        Some(SearchBudget::Time(time)) => Instant::now().checked_add(time),
        _ => None,
    };
    question.check().map_err(refused)?;
    if let Some(shard) = arguments.shard.shard {
        return write_shard(shard, arguments, &question);
    }
    let mut record = Record::open(arguments, &question)?;
    if let Some(rows) = shard::known::<Run>(question.runs)? {
        let read = |(index, run): (usize, Run)| run.read().ok_or_else(|| shard::unreadable(index));
        record.known = rows.into_iter().enumerate().map(read).collect::<Result<_, _>>()?;
    }
    let study = search(arguments, question, &record, deadline)?;
    let answer = Answer {
        document: &report::optimization(&study),
        width: width(common.output.as_deref()),
        picture: Some(&|| Ok(optimization::figure::optimization(&study)?)),
        other: &|format| match format {
            Format::Csv => Ok(optimization::csv(&study)),
            Format::Json => json_text(&json::optimization(&study)),
            format => no_such(format),
        },
    };
    let note = match (record.warning(), study.complete) {
        (Some(trouble), _) => Some(format!("warning: the record is not complete: {trouble}")),
        (None, false) => Some(format!(
            "warning: stopped early, what there is is kept: {} of {} runs{}",
            study.runs.len(),
            study.question.runs,
            match &record.path {
                Some(path) => format!("; --resume {} goes on", path.display()),
                None => String::new(),
            }
        )),
        (None, true) => None,
    };
    Ok(Outcome { note, partial: !study.complete, ..answer.outcome(common)? })
}

/// The lines of the runs of a shard. What compares all runs, and follows the best designs again, is
/// done where they are put together.
fn write_shard(
    shard: Shard,
    arguments: &OptimizeArguments,
    question: &OptimizationProblem,
) -> Result<Outcome, Failure> {
    let foreign = [
        ("--record", arguments.record.is_some()),
        ("--resume", arguments.resume.is_some()),
        ("--budget in seconds", matches!(arguments.budget, Some(SearchBudget::Time(_)))),
    ];
    if let Some((option, _)) = foreign.iter().find(|(_, given)| *given) {
        return Err(Failure::Usage(format!(
            "{option} does not go with --shard, whose lines are the record: leave it out"
        )));
    }
    let inputs = |index: usize| {
        [("seed".to_owned(), question.seed.into()), ("run".to_owned(), index.into())]
            .into_iter()
            .collect()
    };
    let threads = arguments.jobs.map_or_else(rayon::current_num_threads, usize::from);
    let points = Points {
        total: question.runs,
        together: threads,
        bar: "{bar:40} {pos}/{len} runs, {eta} left",
        inputs: &inputs,
    };
    let interrupt = session::interrupt();
    let watch = StudyObserver { stop: &|| interrupt.is_requested(), ..StudyObserver::default() };
    shard::write(shard, &arguments.common, &points, |indices| {
        let runs = on_threads(threads, || search_runs(question, indices, &watch));
        let runs = runs.map_err(refused)?;
        let row = |index: &usize| runs.iter().find(|run| run.number == *index).map(Run::from_run);
        Ok(indices.iter().map(row).collect())
    })
}

fn search(
    arguments: &OptimizeArguments,
    question: OptimizationProblem,
    record: &Record,
    deadline: Option<Instant>,
) -> Result<Study, Failure> {
    let bar = PartsBar::new(
        question.most_work(),
        "{bar:40} {percent} % of the generations, {eta} left at most",
    );
    let interrupt = session::interrupt();
    let watch = StudyObserver {
        stop: &|| {
            interrupt.is_requested() || deadline.is_some_and(|deadline| Instant::now() >= deadline)
        },
        done: &|run| record.write(run),
        progress: &|done| bar.advance(done),
    };
    let known = record.known.clone();
    let study = match arguments.jobs {
        Some(threads) => optimize_on(usize::from(threads), question, known, &watch),
        None => optimize(question, known, &watch),
    };
    bar.finish();
    study.map_err(refused)
}

fn refused(error: OptimizeError) -> Failure {
    let help = match &error {
        OptimizeError::NoRest { .. } => Some("raise `duration` in [run], or damp more"),
        OptimizeError::NoFeasible { exists: true, .. } => {
            Some("give penalty = \"feasible-first\" in [genetic], or the search more generations")
        }
        OptimizeError::NoFeasible { exists: false, .. } => {
            Some("loosen [limits], or give the search more generations")
        }
        OptimizeError::Options(SearchError::Budget { .. }) => {
            Some("raise --budget, or lower --runs")
        }
        OptimizeError::Stopped => Some("give it more time"),
        _ => None,
    };
    Failure::refused(&error, help.map(str::to_owned))
}

/// The record of a search: what it knows, and where the next runs go.
struct Record {
    path: Option<PathBuf>,
    known: Vec<SearchRun>,
    file: Mutex<Option<File>>,
    trouble: Mutex<Option<String>>,
}

/// The largest record that is read, in bytes.
const LARGEST_RECORD: usize = 1 << 30;

impl Record {
    fn open(
        arguments: &OptimizeArguments,
        question: &OptimizationProblem,
    ) -> Result<Self, Failure> {
        let none =
            Self { path: None, known: vec![], file: Mutex::new(None), trouble: Mutex::new(None) };
        let named = [("--record", &arguments.record), ("--resume", &arguments.resume)];
        for (option, path) in named {
            let Some(path) = path else { continue };
            if is_standard(path) {
                return Err(Failure::Usage(format!(
                    "{option} needs a file: runs are written to it"
                )));
            }
            let others = [&arguments.common.output, &arguments.common.plot, &arguments.file];
            if others.into_iter().flatten().any(|other| is_same_file(other, path)) {
                return Err(Failure::Usage(format!(
                    "{option} {} is read or written as something else: give another name",
                    path.display()
                )));
            }
        }
        let (mut known, mut end) = (vec![], 0);
        if let Some(path) = &arguments.resume {
            let text = read_at_most(path, LARGEST_RECORD)?;
            (known, end) = read_record(&text, question).map_err(|error| {
                Failure::because(format!("--resume {}: {error}", path.display()))
            })?;
        }
        let (path, goes_on) = match (&arguments.record, &arguments.resume) {
            (None, None) => return Ok(none),
            (Some(record), Some(resume)) if is_same_file(record, resume) => (resume, true),
            (Some(record), _) => (record, false),
            (None, Some(resume)) => (resume, true),
        };
        let cannot = |error: std::io::Error| {
            Failure::because(format!("cannot write {}: {}", path.display(), error.kind()))
        };
        let file = match goes_on {
            true => {
                let mut file = OpenOptions::new().write(true).open(path).map_err(cannot)?;
                // A line that a killed process left unfinished goes.
                file.set_len(end as u64)
                    .and_then(|()| file.seek(SeekFrom::End(0)))
                    .map_err(cannot)?;
                file
            }
            false => {
                let mut file = Self::create(path)?;
                let mut text = record_head(question)?;
                for run in &known {
                    text += &record_line(run)?;
                }
                file.write_all(text.as_bytes()).map_err(cannot)?;
                file
            }
        };
        Ok(Self { path: Some(path.clone()), known, file: Mutex::new(Some(file)), ..none })
    }

    fn create(path: &Path) -> Result<File, Failure> {
        OpenOptions::new().write(true).create_new(true).open(path).map_err(|error| {
            Failure::because(match error.kind() {
                std::io::ErrorKind::AlreadyExists => format!(
                    "--record {0} exists: take it up with --resume {0}, or give another name",
                    path.display()
                ),
                kind => format!("cannot write {}: {kind}", path.display()),
            })
        })
    }

    /// Writes a run as a whole line; what goes wrong is told at the end.
    fn write(&self, run: &SearchRun) {
        let Ok(mut file) = self.file.lock() else {
            return;
        };
        let Some(open) = file.as_mut() else { return };
        let written = record_line(run)
            .map_err(|error| error.to_string())
            .and_then(|line| open.write_all(line.as_bytes()).map_err(|error| error.to_string()));
        if let Err(error) = written {
            *file = None;
            if let Ok(mut trouble) = self.trouble.lock() {
                *trouble = Some(error);
            }
        }
    }

    fn warning(&self) -> Option<String> {
        self.trouble.lock().ok()?.clone()
    }
}

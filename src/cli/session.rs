//! A session joins a command that runs with its caller: the request to stop, the progress, the words
//! of the command, and a place for notes.
//!
//! The program has one session. A caller inside another process has one for each call, so that
//! calls on several threads do not meet; a thread that runs a command knows its session.

use std::cell::Cell;
use std::ffi::OsString;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Map, Value};

use super::{Failure, Format};
use crate::export::printable;
use crate::{Counter, Interrupt, Progress, Supervision};

/// The session of a call of a command.
#[derive(Default)]
pub(super) struct Session {
    /// Set by an interrupt or at the time limit; work that can hand back a part looks at it.
    pub(super) stop: AtomicBool,
    /// The progress of the work.
    pub(super) progress: Counter,
    /// Set by `--quiet`, and inside another process: no bars, no notes on standard error.
    pub(super) quiet: AtomicBool,
    asked: Mutex<Asked>,
}

/// The request of a session, and the notes on its answer.
#[derive(Default)]
struct Asked {
    words: Vec<String>,
    input: Option<String>,
    notes: Option<Vec<String>>,
    began: Option<Instant>,
    forms: Vec<(&'static str, String)>,
    study: AskedStudy,
}

/// A study that is split over shards, by its identity, and the rows of one that is put together.
#[derive(Default)]
struct AskedStudy {
    command: Vec<String>,
    /// The text of the file that the command read.
    file: Option<String>,
    rows: Option<Vec<Map<String, Value>>>,
}

/// The session of the program.
static OF_PROGRAM: Session = Session {
    stop: AtomicBool::new(false),
    progress: Counter::new(),
    quiet: AtomicBool::new(false),
    asked: Mutex::new(Asked {
        words: Vec::new(),
        input: None,
        notes: None,
        began: None,
        forms: Vec::new(),
        study: AskedStudy { command: Vec::new(), file: None, rows: None },
    }),
};

/// Sessions that are not in use: an interrupt is a flag that lives for ever, so that they are taken
/// again and again.
static IDLE: Mutex<Vec<&'static Session>> = Mutex::new(Vec::new());

thread_local! {
    static CURRENT: Cell<&'static Session> = const { Cell::new(&OF_PROGRAM) };
}

/// Returns the session of this thread.
pub(super) fn current() -> &'static Session {
    CURRENT.get()
}

/// Returns the interrupt of the session of this thread.
pub(super) fn interrupt() -> Interrupt {
    Interrupt::from_flag(&current().stop)
}

/// Returns interrupt and progress of the session of this thread.
pub(super) fn supervision() -> Supervision {
    Supervision { interrupt: interrupt(), progress: Progress::from_counter(&current().progress) }
}

/// Returns a value although a thread panicked that held it: what is kept here has no invariants.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Session {
    /// Begins the session of the program with the words of its command line.
    pub(super) fn of_program(words: &[OsString]) -> &'static Self {
        let words = words.iter().map(|word| word.to_string_lossy().into_owned());
        locked(&OF_PROGRAM.asked).words = words.collect();
        &OF_PROGRAM
    }

    /// Begins a session inside another process, with the words of a command and the text that `-`
    /// stands for; it collects its notes.
    pub(super) fn of_call(words: Vec<String>, input: Option<String>) -> &'static Self {
        let idle = locked(&IDLE).pop();
        let session = idle.unwrap_or_else(|| Box::leak(Box::default()));
        session.stop.store(false, Ordering::Relaxed);
        session.quiet.store(true, Ordering::Relaxed);
        Progress::from_counter(&session.progress).begin(0);
        *locked(&session.asked) = Asked {
            words,
            input,
            notes: Some(Vec::new()),
            began: Some(Instant::now()),
            forms: Vec::new(),
            study: AskedStudy::default(),
        };
        session
    }

    /// Ends a session whose work is done; one with work that never ended is not taken again.
    pub(super) fn end(&'static self) {
        locked(&IDLE).push(self);
    }

    /// Makes this the session of this thread.
    pub(super) fn enter(&'static self) {
        CURRENT.set(self);
    }

    /// Asks the work to stop, whose caller has no use for a part of it: what there is of a result is
    /// not written in other formats.
    pub(super) fn abandon(&self) {
        self.stop.store(true, Ordering::Relaxed);
        locked(&self.asked).began = None;
    }

    /// Whether bars and notes are left out.
    pub(super) fn is_quiet(&self) -> bool {
        self.quiet.load(Ordering::Relaxed)
    }

    /// Returns the words of the command.
    pub(super) fn words(&self) -> Vec<String> {
        locked(&self.asked).words.clone()
    }

    /// Takes the text that stands for standard input, where the caller gave one.
    pub(super) fn take_input(&self) -> Option<String> {
        locked(&self.asked).input.take()
    }

    /// Keeps the words by which the study of the command is known.
    pub(super) fn begin_study(&self, command: Vec<String>) {
        locked(&self.asked).study.command = command;
    }

    /// Keeps the text of the first file that is read, which is that of the problem.
    pub(super) fn keep_file(&self, text: &str) {
        locked(&self.asked).study.file.get_or_insert_with(|| text.to_owned());
    }

    /// Returns the words by which the study is known, and the text of its file.
    pub(super) fn study(&self) -> (Vec<String>, Option<String>) {
        let study = &locked(&self.asked).study;
        (study.command.clone(), study.file.clone())
    }

    /// Makes this the session of a command that was split: its words, the text that `-` stands for,
    /// and the rows of its points.
    pub(super) fn repeat(
        &self,
        command: Vec<String>,
        file: Option<String>,
        rows: Vec<Map<String, Value>>,
    ) {
        let mut asked = locked(&self.asked);
        asked.words = command.clone();
        asked.input = file;
        asked.study = AskedStudy { command, file: None, rows: Some(rows) };
    }

    /// Takes the rows of the points, where they are known.
    pub(super) fn take_rows(&self) -> Option<Vec<Map<String, Value>>> {
        locked(&self.asked).study.rows.take()
    }

    /// Whether this session is inside another process, whose standard input is not read.
    pub(super) fn is_call(&self) -> bool {
        locked(&self.asked).notes.is_some()
    }

    /// Prints a note on standard error, unless `--quiet` is given, or keeps it for the caller.
    pub(super) fn note(&self, text: &str) {
        match &mut locked(&self.asked).notes {
            Some(notes) => notes.push(text.to_owned()),
            None if self.is_quiet() => {}
            None => eprintln!("note: {}", printable(text)),
        }
    }

    /// Writes the result of long work in the other formats as well, and keeps them for the caller:
    /// so they are there without doing the work again. What was quick is quick again.
    pub(super) fn keep_forms(
        &self,
        asked: Format,
        write: impl Fn(Format) -> Result<String, Failure>,
    ) {
        const LONG: Duration = Duration::from_millis(200);
        let began = locked(&self.asked).began;
        if began.is_none_or(|began| began.elapsed() < LONG) {
            return;
        }
        let others = [Format::Text, Format::Latex, Format::Html, Format::Svg, Format::Csv];
        for format in others.into_iter().filter(|format| *format != asked) {
            // A kind of result does not have every format.
            if let Ok(text) = write(format) {
                locked(&self.asked).forms.push((format.name(), text));
            }
        }
    }

    /// Takes the results in other formats that were kept.
    pub(super) fn take_forms(&self) -> Vec<(&'static str, String)> {
        std::mem::take(&mut locked(&self.asked).forms)
    }

    /// Takes the notes that were kept.
    pub(super) fn take_notes(&self) -> Vec<String> {
        locked(&self.asked).notes.as_mut().map(std::mem::take).unwrap_or_default()
    }
}

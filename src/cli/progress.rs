//! A bar on standard error for long work, where that is a terminal and `--quiet` is not given.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use super::session::{self, Session};
use crate::Progress;

/// The template of the bar of a sweep.
pub(super) const MOTIONS: &str = "{bar:40} {pos}/{len} motions, {eta} left";

/// A bar that shows the parts of a work, and counts them in the session.
pub(super) struct PartsBar {
    bar: ProgressBar,
    progress: Progress,
}

impl PartsBar {
    /// Begins a work of so many parts; `template` says what stands beside the bar.
    pub(super) fn new(parts: usize, template: &str) -> Self {
        let progress = session::supervision().progress;
        progress.begin(parts);
        Self { bar: bar(session::current(), parts, template), progress }
    }

    /// Counts so many more parts as done.
    pub(super) fn advance(&self, parts: usize) {
        self.bar.inc(parts as u64);
        for _ in 0..parts {
            self.progress.advance();
        }
    }

    /// Takes the bar away.
    pub(super) fn finish(self) {
        self.bar.finish_and_clear();
    }
}

/// A bar of so much work; `template` says what stands beside it.
fn bar(session: &Session, length: usize, template: &str) -> ProgressBar {
    let bar = match session.is_quiet() {
        true => ProgressBar::hidden(),
        false => ProgressBar::new(length as u64),
    };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

/// Does long work with a bar, `40 % of the calculation`.
pub(super) fn with_progress<T>(of_what: &str, work: impl FnOnce() -> T) -> T {
    /// Work that is done before this needs no bar.
    const SOON: Duration = Duration::from_millis(500);
    const EVERY: Duration = Duration::from_millis(100);
    let session = session::current();
    if session.is_quiet() {
        return work();
    }
    let (done, waits) = channel::<()>();
    let template = format!("{{bar:40}} {{percent}} % {of_what}, {{eta}} left");
    let watcher = std::thread::spawn(move || {
        let is_done = |wait: Duration| waits.recv_timeout(wait) != Err(RecvTimeoutError::Timeout);
        if is_done(SOON) {
            return;
        }
        let bar = bar(session, 0, &template);
        while !is_done(EVERY) {
            let (position, length) = session.progress.read();
            bar.set_length(length);
            bar.set_position(position);
        }
        bar.finish_and_clear();
    });
    let result = work();
    drop(done);
    let _ = watcher.join();
    result
}

//! A bar on standard error for long work, where that is a terminal and `--quiet` is not given.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use lindstedt::Counter;
use lindstedt::export::printable;

/// The progress of the work.
pub(super) static PROGRESS: Counter = Counter::new();

/// Set by `--quiet`.
pub(super) static QUIET: AtomicBool = AtomicBool::new(false);

/// Prints a note on standard error, unless `--quiet` is given.
pub(super) fn note(text: &str) {
    if !QUIET.load(Ordering::Relaxed) {
        eprintln!("note: {}", printable(text));
    }
}

/// What stands beside the bar of a sweep.
pub(super) const MOTIONS: &str = "{bar:40} {pos}/{len} motions, {eta} left";

/// A bar of so much work; `template` says what stands beside it.
pub(super) fn bar(length: usize, template: &str) -> ProgressBar {
    let bar = match QUIET.load(Ordering::Relaxed) {
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
    let (done, waits) = channel::<()>();
    let template = format!("{{bar:40}} {{percent}} % {of_what}, {{eta}} left");
    let watcher = std::thread::spawn(move || {
        let is_done = |wait: Duration| waits.recv_timeout(wait) != Err(RecvTimeoutError::Timeout);
        if is_done(SOON) {
            return;
        }
        let bar = bar(0, &template);
        while !is_done(EVERY) {
            let (position, length) = PROGRESS.read();
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

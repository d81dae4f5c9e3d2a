//! Work within its limits: on a thread of its own, until its end, an interrupt or the time limit.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use lindstedt_expr::parallel::on_threads;

use super::session::Session;
use super::{Failure, Outcome, Work};

/// The result of the work; `None` if it panicked.
pub(super) type Worked = Option<Result<Outcome, Failure>>;

/// Exit code and message of work that ends without a result.
pub(super) type InVain = (u8, String);

/// Does work until its end, an interrupt or the time limit: what came of it, where anything did,
/// and what to say where nothing did because it was ended.
pub(super) fn within_limits(
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
pub(super) fn is_forked() -> bool {
    static FIRST: AtomicU32 = AtomicU32::new(0);
    let own = std::process::id();
    let first = FIRST.compare_exchange(0, own, Ordering::Relaxed, Ordering::Relaxed);
    first.is_err_and(|first| first != own)
}

/// The limits of a work.
pub(super) struct Limits<'a> {
    /// The time limit in seconds.
    pub(super) timeout: Option<f64>,
    /// The time to wait for a part of the result.
    pub(super) patience: fn(&Session) -> Duration,
    /// Is told the progress again and again, and says whether to go on.
    pub(super) watch: Option<Watch<'a>>,
}

/// Takes the parts done and all of them, and returns whether the work is to go on.
pub(super) type Watch<'a> = &'a mut dyn FnMut(u64, u64) -> bool;

/// The time between two looks at the progress of a call.
pub(super) const EVERY: Duration = Duration::from_millis(50);

/// The next message, within the limit.
pub(super) fn receive(
    receiver: &Receiver<Message>,
    limit: Option<Duration>,
) -> Result<Message, RecvTimeoutError> {
    match limit {
        None => receiver.recv().map_err(|_| RecvTimeoutError::Disconnected),
        Some(limit) => receiver.recv_timeout(limit),
    }
}

/// The exit code of a program ended by an interrupt, by the convention of shells.
pub(super) const INTERRUPTED: u8 = 130;

/// A message to the main thread.
pub(super) enum Message {
    /// The work is done; nothing where it broke.
    Done(Worked),
    /// The user wants it to end.
    Interrupt,
}

/// Asks the work to hand back what it has, and waits a little for it; not at all for work that has
/// no parts.
pub(super) fn wait_for_part(
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

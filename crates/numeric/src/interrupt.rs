//! A request to stop, which a long computation checks between its steps and answers by returning
//! its results so far; and a counter that shows its progress.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// A flag that asks a computation to stop; the default never does.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use std::sync::atomic::{AtomicBool, Ordering};
/// use lindstedt::Interrupt;
///
/// static STOP: AtomicBool = AtomicBool::new(false);
/// let interrupt = Interrupt::from_flag(&STOP);
/// assert!(!interrupt.is_requested());
/// STOP.store(true, Ordering::Relaxed);
/// assert!(interrupt.is_requested());
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Interrupt(Option<&'static AtomicBool>);

impl Interrupt {
    /// Makes an interrupt that is requested while `flag` is set.
    pub fn from_flag(flag: &'static AtomicBool) -> Self {
        Self(Some(flag))
    }

    /// Whether the computation is asked to stop.
    pub fn is_requested(self) -> bool {
        self.0.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }
}

/// An observer of the progress of a computation; the default has none.
#[derive(Clone, Copy, Debug, Default)]
pub struct Progress(Option<&'static Counter>);

/// The progress of a computation: the parts done, and all of them.
#[derive(Debug, Default)]
pub struct Counter {
    done: AtomicU64,
    all: AtomicU64,
}

impl Counter {
    /// A counter without parts.
    pub const fn new() -> Self {
        Self { done: AtomicU64::new(0), all: AtomicU64::new(0) }
    }

    /// Returns the number of parts done and of all parts, both zero before the work begins.
    pub fn read(&self) -> (u64, u64) {
        (self.done.load(Ordering::Relaxed), self.all.load(Ordering::Relaxed))
    }
}

impl Progress {
    /// Makes an observer that shows the progress in `counter`.
    pub fn from_counter(counter: &'static Counter) -> Self {
        Self(Some(counter))
    }

    /// Begins to count the parts of a computation, `parts` in all.
    pub fn begin(self, parts: usize) {
        if let Some(counter) = self.0 {
            counter.done.store(0, Ordering::Relaxed);
            counter.all.store(parts as u64, Ordering::Relaxed);
        }
    }

    /// Counts one more part as done.
    pub fn advance(self) {
        if let Some(counter) = self.0 {
            counter.done.fetch_add(1, Ordering::Relaxed);
        }
    }
}

impl PartialEq for Progress {
    fn eq(&self, other: &Self) -> bool {
        match (self.0, other.0) {
            (Some(one), Some(other)) => std::ptr::eq(one, other),
            (one, other) => one.is_none() && other.is_none(),
        }
    }
}

/// Interrupt and progress of a long computation; the default has neither.
///
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Supervision {
    /// The interrupt.
    pub interrupt: Interrupt,
    /// The observer of the progress.
    pub progress: Progress,
}

impl PartialEq for Interrupt {
    fn eq(&self, other: &Self) -> bool {
        match (self.0, other.0) {
            (Some(one), Some(other)) => std::ptr::eq(one, other),
            (one, other) => one.is_none() && other.is_none(),
        }
    }
}

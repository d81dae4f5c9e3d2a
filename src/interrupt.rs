//! A request to stop: long work looks at it between its steps, and hands back what it has.

use std::sync::atomic::{AtomicBool, Ordering};

/// Somebody who may ask to stop; nobody by default.
///
/// ```
/// use std::sync::atomic::{AtomicBool, Ordering};
/// use lindstedt::Interrupt;
///
/// static STOP: AtomicBool = AtomicBool::new(false);
/// let interrupt = Interrupt::by(&STOP);
/// assert!(!interrupt.is_requested());
/// STOP.store(true, Ordering::Relaxed);
/// assert!(interrupt.is_requested());
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Interrupt(Option<&'static AtomicBool>);

impl Interrupt {
    /// Asked for by setting this flag.
    pub fn by(flag: &'static AtomicBool) -> Self {
        Self(Some(flag))
    }

    /// Whether to stop.
    pub fn is_requested(self) -> bool {
        self.0.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }
}

impl PartialEq for Interrupt {
    fn eq(&self, other: &Self) -> bool {
        match (self.0, other.0) {
            (Some(one), Some(other)) => std::ptr::eq(one, other),
            (one, other) => one.is_none() && other.is_none(),
        }
    }
}

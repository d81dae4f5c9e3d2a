//! Memory that ended paths leave to the next ones of the same equations.
//!
//! The first write to new memory costs the operating system more than a step that is written there,
//! and a sweep follows hundreds of motions one after the other. A flight from one impact to the next is
//! two or three steps long, so that five lists of its own would take as long as a step.

use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex, PoisonError};

use super::EventCrossing;
use super::steps::TaylorStep;

/// The lists that are free, shared by all paths of the same equations.
#[derive(Clone, Debug, Default)]
pub(super) struct SpareMemory(Arc<Mutex<FreeLists>>);

/// Free lists and the bytes in them.
#[derive(Debug, Default)]
struct FreeLists {
    #[expect(
        clippy::vec_box,
        reason = "a path takes its lists and leaves them without moving them"
    )]
    lists: Vec<Box<PathLists>>,
    bytes: usize,
}

/// All lists of a path by Taylor series.
#[derive(Clone, Debug, Default)]
pub(super) struct PathLists {
    /// The steps that are kept, in order.
    pub(super) steps: Vec<TaylorStep>,
    /// The coefficients of `s^0, s^1, ...`, step by step and state by state.
    pub(super) coefficients: Vec<f64>,
    /// The points of expansion, step by step.
    pub(super) points: Vec<f64>,
    /// The events met, in order.
    pub(super) occurrences: Vec<EventCrossing>,
    /// The states at the end.
    pub(super) last: Vec<f64>,
}

impl PathLists {
    const EMPTY: Self = Self {
        steps: vec![],
        coefficients: vec![],
        points: vec![],
        occurrences: vec![],
        last: vec![],
    };

    fn clear(&mut self) {
        self.steps.clear();
        self.occurrences.clear();
        [&mut self.coefficients, &mut self.points, &mut self.last].into_iter().for_each(Vec::clear);
    }

    fn bytes(&self) -> usize {
        let numbers = [&self.coefficients, &self.points, &self.last];
        self.steps.capacity() * size_of::<TaylorStep>()
            + self.occurrences.capacity() * size_of::<EventCrossing>()
            + numbers.iter().map(|list| list.capacity() * size_of::<f64>()).sum::<usize>()
    }
}

impl SpareMemory {
    /// Number of bytes of all lists that are kept: those of a few threads with eight long motions each, or of many
    /// short flights from impact to impact.
    const MOST_BYTES_TOGETHER: usize = 1 << 28;
    /// Number of bytes of the lists of a path beyond which they are not kept.
    const MOST_BYTES: usize = 1 << 22;

    /// Empty lists, in free memory if there is any.
    pub(super) fn lists(&self) -> SparingLists {
        let mut free = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let lists = free.lists.pop();
        free.bytes -= lists.as_ref().map_or(0, |lists| lists.bytes());
        SparingLists { lists, home: self.clone() }
    }

    fn put(&self, mut lists: Box<PathLists>) {
        lists.clear();
        let bytes = lists.bytes();
        let mut free = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let has_room = free.bytes + bytes <= Self::MOST_BYTES_TOGETHER;
        if has_room && (1..=Self::MOST_BYTES).contains(&bytes) {
            free.bytes += bytes;
            free.lists.push(lists);
        }
    }
}

/// Lists that leave their memory to the next path.
#[derive(Clone, Debug)]
pub(super) struct SparingLists {
    /// `None` until something is written to new memory.
    lists: Option<Box<PathLists>>,
    home: SpareMemory,
}

impl Deref for SparingLists {
    type Target = PathLists;

    fn deref(&self) -> &PathLists {
        const EMPTY: &PathLists = &PathLists::EMPTY;
        self.lists.as_deref().unwrap_or(EMPTY)
    }
}

impl DerefMut for SparingLists {
    fn deref_mut(&mut self) -> &mut PathLists {
        self.lists.get_or_insert_default()
    }
}

impl Drop for SparingLists {
    fn drop(&mut self) {
        if let Some(lists) = self.lists.take() {
            self.home.put(lists);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_begin_empty_in_the_memory_of_a_path_that_is_gone() {
        let memory = SpareMemory::default();
        let (mut first, mut second) = (memory.lists(), memory.lists());
        first.coefficients.extend([1.0; 100]);
        first.last.push(3.0);
        second.coefficients.push(2.0);
        let place = first.coefficients.as_ptr();
        drop(first);
        let third = memory.lists();
        assert!(third.coefficients.is_empty() && third.last.is_empty());
        assert_eq!(third.coefficients.as_ptr(), place);
        assert_eq!(second.coefficients, [2.0]);
        // Lists in use are nobody else's.
        assert!(memory.lists().coefficients.capacity() == 0);
    }
}

//! Memory that ended paths leave to the next ones of the same equations.
//!
//! The first write to new memory costs the operating system more than a step that is written there,
//! and a sweep follows hundreds of motions one after the other.

use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex, PoisonError};

/// The lists that are free, shared by all paths of the same equations.
#[derive(Clone, Debug, Default)]
pub(super) struct SpareMemory(Arc<Mutex<FreeLists>>);

/// Free lists and the bytes in them.
#[derive(Debug, Default)]
struct FreeLists {
    lists: Vec<Vec<f64>>,
    bytes: usize,
}

impl SpareMemory {
    /// Number of bytes of all lists that are kept: those of a few threads with eight long motions each, or of many
    /// short flights from impact to impact.
    const MOST_BYTES_TOGETHER: usize = 1 << 28;
    /// Number of bytes of a list beyond which it is not kept.
    const MOST_BYTES: usize = 1 << 22;

    /// An empty list, in free memory if there is any.
    pub(super) fn list(&self) -> SparingList {
        let mut free = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let numbers = free.lists.pop().unwrap_or_default();
        free.bytes -= Self::bytes(&numbers);
        SparingList { numbers, home: self.clone() }
    }

    fn put(&self, mut list: Vec<f64>) {
        let bytes = Self::bytes(&list);
        let mut free = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let has_room = free.bytes + bytes <= Self::MOST_BYTES_TOGETHER;
        if has_room && (1..=Self::MOST_BYTES).contains(&bytes) {
            list.clear();
            free.bytes += bytes;
            free.lists.push(list);
        }
    }

    fn bytes(list: &Vec<f64>) -> usize {
        list.capacity() * size_of::<f64>()
    }
}

/// A list of numbers that leaves its memory to the next one.
#[derive(Clone, Debug)]
pub(super) struct SparingList {
    numbers: Vec<f64>,
    home: SpareMemory,
}

impl From<Vec<f64>> for SparingList {
    fn from(numbers: Vec<f64>) -> Self {
        Self { numbers, home: SpareMemory::default() }
    }
}

impl Deref for SparingList {
    type Target = Vec<f64>;

    fn deref(&self) -> &Vec<f64> {
        &self.numbers
    }
}

impl DerefMut for SparingList {
    fn deref_mut(&mut self) -> &mut Vec<f64> {
        &mut self.numbers
    }
}

impl Drop for SparingList {
    fn drop(&mut self) {
        self.home.put(std::mem::take(&mut self.numbers));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_begins_empty_in_the_memory_of_one_that_is_gone() {
        let memory = SpareMemory::default();
        let (mut first, mut second) = (memory.list(), memory.list());
        first.extend([1.0; 100]);
        second.push(2.0);
        let place = first.as_ptr();
        drop(first);
        let third = memory.list();
        assert!(third.is_empty() && third.as_ptr() == place);
        assert_eq!(*second, [2.0]);
        // A list in use is nobody else's.
        assert!(memory.list().capacity() == 0);
    }
}

//! Runs independent pieces of work on all threads of the current pool; one after the other without
//! the feature `parallel`.
//!
//! Results are in the order of the items, whatever the number of threads.

use std::sync::{Mutex, PoisonError};

use crate::symbol::letters::ResultSymbols;

/// Applies `work` to each item in parallel and returns the results in order.
pub fn par_map<I: Sync, T: Send>(items: &[I], work: impl Fn(&I) -> T + Sync) -> Vec<T> {
    let results: Vec<Mutex<Option<T>>> = items.iter().map(|_| Mutex::new(None)).collect();
    run(items.len(), &|number| {
        let result = work(&items[number]);
        *results[number].lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
    });
    let results = results.into_iter();
    results
        .filter_map(|result| result.into_inner().unwrap_or_else(PoisonError::into_inner))
        .collect()
}

/// Calls `work` with every number below `count`. It is not generic, so that it is compiled once for
/// all kinds of work.
fn run(count: usize, work: &(dyn Fn(usize) + Sync)) {
    let letters = ResultSymbols::in_force_here();
    let work = &|number| {
        let _letters = letters.exactly();
        work(number);
    };
    #[cfg(feature = "parallel")]
    rayon::iter::ParallelIterator::for_each(
        rayon::iter::IntoParallelIterator::into_par_iter(0..count),
        work,
    );
    #[cfg(not(feature = "parallel"))]
    (0..count).for_each(work);
}

/// Number of threads.
pub fn threads() -> usize {
    #[cfg(feature = "parallel")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "parallel"))]
    return 1;
}

/// Runs `work` in a pool of this many threads; in the current pool if no other can be made.
#[cfg(feature = "parallel")]
pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_keep_their_order() {
        let items: Vec<usize> = (0..1000).collect();
        let expected: Vec<usize> = items.iter().map(|item| item * item).collect();
        assert_eq!(par_map(&items, |item| item * item), expected);
        assert_eq!(par_map(&[] as &[usize], |item| *item), Vec::<usize>::new());
        assert!(threads() > 0);
    }

    #[cfg(feature = "parallel")]
    #[test]
    fn a_pool_has_its_own_threads() {
        assert_eq!(on_threads(3, threads), 3);
    }
}

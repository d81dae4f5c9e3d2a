//! Several runs side by side on one core: eight motions share each instruction of the series.
//!
//! Each run is in a phase of its own, so a pool of them is kept, and at every turn eight that want the same series get
//! it together. The lanes never touch each other and no operation is fused or reordered: a run gives bit for bit what it
//! gives alone, whatever runs beside it.

use pulp::Arch;

use super::run::{Equation, Runner};
use super::taylor::{Coefficients, HIGHEST_ORDER, Moment, Terms, contact, flight};

/// Motions in one instruction: a register of 512 bits, or two or four smaller ones.
const LANES: usize = 8;

/// Runs under way at once: so many that eight of them nearly always want the same series.
const POOL: usize = 48;

/// Follows every run to its end, and hands each over as it ends, with its number. All have the same tolerance.
pub(super) fn follow(runs: impl Iterator<Item = Runner>, mut done: impl FnMut(usize, Runner)) {
    let arch = Arch::new();
    let mut waiting = runs.enumerate();
    let mut pool: Vec<(usize, Runner)> = Vec::with_capacity(POOL);
    let mut flights: Vec<usize> = Vec::with_capacity(POOL);
    let mut contacts: Vec<usize> = Vec::with_capacity(POOL);
    // Places of the pool that have no series to come yet.
    let mut fresh: Vec<usize> = Vec::with_capacity(POOL);
    let mut series = Box::new(Coefficients::<LANES>::new());
    let mut moment = Moment::<LANES>::new();
    for (number, runner) in waiting.by_ref().take(POOL) {
        fresh.push(pool.len());
        pool.push((number, runner));
    }
    loop {
        while let Some(place) = fresh.pop() {
            let Some(entry) = pool.get_mut(place) else {
                continue;
            };
            match entry.1.wants() {
                Some(Equation::Flight) => flights.push(place),
                Some(Equation::Contact) => contacts.push(place),
                None => {
                    // Its place goes to the next run; without one it stays behind, ended.
                    if let Some(next) = waiting.next() {
                        let (number, runner) = std::mem::replace(entry, next);
                        done(number, runner);
                        fresh.push(place);
                    }
                }
            }
        }
        let flying = flights.len() >= contacts.len();
        let queue = if flying { &mut flights } else { &mut contacts };
        if queue.is_empty() {
            break;
        }
        let group: Vec<usize> = queue.split_off(queue.len().saturating_sub(LANES));
        let mut terms = Terms::default();
        let mut order = HIGHEST_ORDER;
        for lane in 0..LANES {
            // Lanes without a run repeat the last one.
            let Some((_, runner)) = group.get(lane).or(group.last()).and_then(|place| pool.get(*place)) else {
                continue;
            };
            runner.moment(lane, &mut moment);
            terms = terms.or(runner.terms());
            order = runner.order();
        }
        let (moment, series) = (&moment, &mut *series);
        if flying {
            arch.dispatch(|| flight(moment, order, terms, series));
        } else {
            arch.dispatch(|| contact(moment, order, terms, series));
        }
        for (lane, &place) in group.iter().enumerate() {
            let mut own = [[0.0; HIGHEST_ORDER + 1]; 3];
            for (own, all) in own.iter_mut().zip([&series.place, &series.velocity, &series.time]) {
                for (coefficient, lanes) in own[..=order].iter_mut().zip(all) {
                    *coefficient = lanes[lane];
                }
            }
            let [place_series, velocity, time] = &mut own;
            if let Some((_, runner)) = pool.get_mut(place) {
                runner.advance(place_series, velocity, time);
            }
            fresh.push(place);
        }
    }
    for (number, runner) in pool {
        done(number, runner);
    }
}

//! Several runs side by side on one core: eight motions share each instruction of the series.
//!
//! Each run is in a phase of its own, so a pool of runs is kept, and in each round eight that need
//! the same series get it together. The lanes never touch each other and no operation is fused or
//! reordered: a run gives bit for bit the same result as alone, whatever runs in the other lanes.

use pulp::{Arch, Simd, WithSimd};

use super::course::{Courses, courses};
use super::recurrences::{contact, flight};
use super::series::{Ends, HIGHEST_ORDER, Inputs, SeriesCoefficients, Terms};
use super::step::step_lengths;
use super::{Runner, StepEquation};

/// Number of motions in one instruction: a register of 512 bits, or two or four smaller ones.
const LANES: usize = 8;

/// Number of runs in the pool: so many that eight of them always need the same series, and so few
/// that they stay in the cache.
const POOL: usize = 16;

/// The series of one group; always inlined, so that it uses the widest registers available.
struct LaneExpansion<'a> {
    inputs: &'a Inputs<LANES>,
    order: usize,
    terms: Terms,
    series: &'a mut SeriesCoefficients<LANES>,
    equation: StepEquation,
}

impl WithSimd for LaneExpansion<'_> {
    /// The reach of the series.
    type Output = [f64; LANES];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [f64; LANES] {
        match self.equation {
            StepEquation::Flight => flight(self.inputs, self.order, self.terms, self.series),
            StepEquation::Contact => contact(self.inputs, self.order, self.terms, self.series),
        }
        step_lengths(&self.series.velocity, self.order, &self.inputs.size, &self.inputs.allowed)
    }
}

/// The values at the ends of the steps, and the events within them.
struct Evaluation<'a> {
    series: &'a SeriesCoefficients<LANES>,
    inputs: &'a Inputs<LANES>,
    lengths: &'a [f64; LANES],
    order: usize,
    equation: StepEquation,
    ends: &'a mut Ends<LANES>,
    courses: &'a mut Courses<LANES>,
}

impl WithSimd for Evaluation<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (step, ends) = ((self.order, self.equation), self.ends);
        *ends = self.series.ends(self.inputs, self.lengths, self.order, self.equation);
        courses(self.series, step, self.inputs, self.lengths, ends, self.courses);
    }
}

/// The places of the next group, from the longer of the two queues: their number, and the series
/// that they need.
fn next_group(
    flights: &mut Vec<usize>,
    contacts: &mut Vec<usize>,
) -> ([usize; LANES], usize, StepEquation) {
    let (queue, equation) = if flights.len() >= contacts.len() {
        (flights, StepEquation::Flight)
    } else {
        (contacts, StepEquation::Contact)
    };
    let mut group = [0; LANES];
    let mut count = 0;
    while count < LANES
        && let Some(place) = queue.pop()
    {
        group[count] = place;
        count += 1;
    }
    (group, count, equation)
}

/// Follows every run to its end, and passes each on with its number as it ends. All have the same
/// tolerance.
pub(in crate::impact) fn follow(
    runs: impl Iterator<Item = Runner>,
    mut done: impl FnMut(usize, Runner),
) {
    let arch = Arch::new();
    let mut waiting = runs.enumerate();
    let mut pool: Vec<(usize, Runner)> = Vec::with_capacity(POOL);
    let mut flights: Vec<usize> = Vec::with_capacity(POOL);
    let mut contacts: Vec<usize> = Vec::with_capacity(POOL);
    // Indices of the pool whose next series is not determined yet.
    let mut fresh: Vec<usize> = Vec::with_capacity(POOL);
    let mut series = Box::new(SeriesCoefficients::<LANES>::new());
    let mut inputs = Inputs::<LANES>::new();
    let (mut ends, mut courses) = (Ends::<LANES>::new(), Courses::<LANES>::new());
    for (number, runner) in waiting.by_ref().take(POOL) {
        fresh.push(pool.len());
        pool.push((number, runner));
    }
    loop {
        while let Some(place) = fresh.pop() {
            let Some(entry) = pool.get_mut(place) else {
                continue;
            };
            match entry.1.next_equation() {
                Some(StepEquation::Flight) => flights.push(place),
                Some(StepEquation::Contact) => contacts.push(place),
                None => {
                    // Its slot goes to the next run, or stays unused.
                    if let Some(next) = waiting.next() {
                        let (number, runner) = std::mem::replace(entry, next);
                        done(number, runner);
                        fresh.push(place);
                    }
                }
            }
        }
        let (group, count, equation) = next_group(&mut flights, &mut contacts);
        let Some(last) = count.checked_sub(1) else {
            break;
        };
        let mut terms = Terms::default();
        let mut order = HIGHEST_ORDER;
        for lane in 0..LANES {
            // Lanes without a run repeat the last one.
            if let Some((_, runner)) = pool.get(group[lane.min(last)]) {
                runner.inputs(lane, &mut inputs);
                terms = terms.or(runner.terms());
                order = runner.order();
            }
        }
        let proposed = arch.dispatch(LaneExpansion {
            inputs: &inputs,
            order,
            terms,
            series: &mut series,
            equation,
        });
        let mut lengths = [0.0; LANES];
        for (lane, &place) in group[..count].iter().enumerate() {
            if let Some((_, runner)) = pool.get_mut(place) {
                lengths[lane] = runner.step_length(proposed[lane]);
            }
        }
        arch.dispatch(Evaluation {
            series: &series,
            inputs: &inputs,
            lengths: &lengths,
            order,
            equation,
            ends: &mut ends,
            courses: &mut courses,
        });
        for (lane, &place) in group[..count].iter().enumerate() {
            if let Some((_, runner)) = pool.get_mut(place) {
                runner.advance(ends.lane(lane), courses.lane(lane), || series.lane(order, lane));
            }
            fresh.push(place);
        }
    }
    for (number, runner) in pool {
        done(number, runner);
    }
}

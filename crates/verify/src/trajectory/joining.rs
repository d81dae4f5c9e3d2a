//! Attractors of motions from many starts that are followed only until it is certain on which of them they settle.
//!
//! ```text
//! followed to the end:   motions that are the first to settle on an attractor, or come near none
//! joins an earlier one:  a motion in the neighbourhood of its attractor, early enough to settle by the end
//! ```
//!
//! Starts are taken in batches, each twice as large as the one before. Between two batches the
//! [neighbourhoods](super::neighbourhood) of the new attractors are computed, and motions of the next batches are
//! looked at on the section for a quarter of the time. Those that have joined none are then followed to the end
//! from their start. In: a course that is driven with the period of its section, or not driven, and its starts. Out:
//! the attractors that a [sweep](super::sweep) finds, and the fate of each start. Cost: with few attractors that of the way into
//! the neighbourhoods; at most a quarter more than that of the sweep. Equations with corners, walls, events, or another
//! period are followed to the end.

use super::attractors::{Basins, Fate, Member, SAME, SETTLED, largest_value, least_extents};
use super::neighbourhood::{Neighbourhood, PeriodMap};
use super::sweep::{course_at, sweep};
use super::{PoincareSection, SweptMotion, TrajectoryError, TrajectoryRequest};
use crate::parallel::{par_map, threads};
use crate::symbol::Symbol;
use crate::system::{Integrator, LANES, Path, PathEnd, SideBySide, Solver};

/// The attractors of motions from many starts.
#[derive(Clone, Debug, PartialEq)]
pub struct SettledStarts {
    /// The starts whose motions were followed, in their order; all of them, unless there was an interrupt.
    pub starts: Vec<Vec<f64>>,
    /// The attractors, and the fate of each start.
    pub basins: Basins,
    /// The number of the start of each motion that ended before its time, and the reason.
    pub ended: Vec<(usize, PathEnd)>,
    /// The number of motions that were followed to the end.
    pub followed: usize,
}

/// Finds the attractors of the course from the values of states at its start, and on which each motion settles, as
/// [`sweep`] and [`Basins::new`] do; `progress` is called after each motion. A motion that has come so near to the
/// attractor of an earlier one that it settles on it before the end is not followed any further.
///
/// # Errors
/// As for [`sweep`].
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::Oscillator;
/// use lindstedt::expr::parse_expression;
/// use lindstedt::trajectory::{PoincareSection, TrajectoryRequest, sweep_to_attractors};
///
/// // A ball that is pushed out of the middle of two wells settles in one of them.
/// let wells = Oscillator::parse("x'' + x'/2 - x + x^3 = 0")?;
/// let mut course = TrajectoryRequest::of_equation(&wells);
/// course.section = Some(PoincareSection::Every(parse_expression("1")?));
/// (course.duration, course.after) = (200.0, 150.0);
/// let grid: Vec<Vec<f64>> = (1..=50).flat_map(|k| [-0.02, 0.02].map(|x| vec![x * f64::from(k)])).collect();
/// let found = sweep_to_attractors(&course, &["x".into()], &grid, || ()).map_err(|(_, error)| error)?;
/// assert_eq!(found.basins.attractors.iter().map(|own| own.motions).collect::<Vec<_>>(), [50, 50]);
/// assert!(found.followed < 20);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep_to_attractors(
    course: &TrajectoryRequest,
    names: &[Symbol],
    grid: &[Vec<f64>],
    progress: impl Fn() + Sync,
) -> Result<SettledStarts, (usize, TrajectoryError)> {
    let largest = largest_value(grid.iter());
    let watch = grid.first().and_then(|first| Watch::new(&course_at(course, names, first)));
    let mut motions: Vec<StartedMotion> = Vec::with_capacity(grid.len());
    let mut known: Vec<Known> = Vec::new();
    let mut batch = 2 * LANES;
    let mut first = 0;
    while first < grid.len() && !course.interrupt.is_requested() {
        // Without a map all are one batch.
        let count = if watch.is_some() { batch } else { grid.len() };
        let starts = &grid[first..grid.len().min(first + count)];
        let joined = match &watch {
            Some(watch) if !known.is_empty() => watch.joined(course, names, starts, &known),
            _ => vec![None; starts.len()],
        };
        joined.iter().flatten().for_each(|_| progress());
        let rest: Vec<usize> = (0..starts.len()).filter(|index| joined[*index].is_none()).collect();
        let own: Vec<Vec<f64>> = rest.iter().map(|index| starts[*index].clone()).collect();
        let followed = sweep(course, names, &own, &progress)
            .map_err(|(number, error)| (first + rest[number], error))?;
        let mut followed = followed.into_iter().peekable();
        for (start, joined) in starts.iter().zip(joined) {
            // After an interrupt there are fewer motions than were asked for.
            let motion = match joined {
                Some(earlier) => Some(StartedMotion::Joins(start.clone(), earlier)),
                None => followed
                    .next_if(|motion| motion.values == *start)
                    .map(|motion| StartedMotion::Followed(Box::new(motion))),
            };
            motions.extend(motion);
        }
        if let Some(watch) = &watch {
            watch.learn(&motions, largest, &mut known);
        }
        first += starts.len();
        batch *= 2;
    }
    let followed = motions.iter().enumerate().filter_map(|(index, motion)| match motion {
        StartedMotion::Followed(motion) => Some((index, motion.reason)),
        StartedMotion::Joins(..) => None,
    });
    let followed: Vec<(usize, PathEnd)> = followed.collect();
    Ok(SettledStarts {
        basins: Basins::of_members(&members(&motions), largest),
        followed: followed.len(),
        ended: followed.into_iter().filter(|(_, reason)| *reason != PathEnd::Reached).collect(),
        starts: motions.into_iter().map(StartedMotion::into_start).collect(),
    })
}

/// A motion from one of the starts.
enum StartedMotion {
    Followed(Box<SweptMotion>),
    /// The start, and the number of the motion that it joins.
    Joins(Vec<f64>, usize),
}

impl StartedMotion {
    fn into_start(self) -> Vec<f64> {
        match self {
            Self::Followed(motion) => motion.values,
            Self::Joins(start, _) => start,
        }
    }
}

fn members(motions: &[StartedMotion]) -> Vec<Member<'_>> {
    let members = motions.iter().map(|motion| match motion {
        StartedMotion::Followed(motion) => Member::Followed(motion),
        StartedMotion::Joins(_, earlier) => Member::Joins(*earlier),
    });
    members.collect()
}

/// An attractor that motions may join.
struct Known {
    /// The number of the first motion that settles on it.
    motion: usize,
    /// `None` if motions near it do not come nearer with each return.
    neighbourhood: Option<Neighbourhood>,
    /// Bounds from below of the extents of the states.
    sizes: Vec<f64>,
}

/// A course whose motions are looked at on the section.
struct Watch {
    map: PeriodMap,
    solver: Solver,
    period: f64,
    /// The number of the first state on the section that counts, and of the last, counted from 1.
    section: [usize; 2],
    step_limit: usize,
}

/// Periods between two looks at motions: they begin anew, with a shorter step than they could take.
const LOOK: usize = 6;

impl Watch {
    /// `None` for equations that are not smooth, or do not have the period of the section.
    fn new(course: &TrajectoryRequest) -> Option<Self> {
        let Some(PoincareSection::Every(period)) = &course.section else { return None };
        let is_free = course.walls.is_empty() && course.events.is_empty();
        if !is_free || course.static_friction.is_some() {
            return None;
        }
        let period = period.evaluate(&course.values).ok().filter(|period| *period > 0.0)?;
        // The states of every look are asked for.
        let course = &TrajectoryRequest { keep_from: f64::NEG_INFINITY, ..course.clone() };
        let ready = course.ready(Integrator::Taylor).ok()?;
        if !ready.critical.is_empty() || ready.states.len() != course.rates.states.len() {
            return None;
        }
        let count = (course.duration / period).floor();
        let before = (course.after / period).ceil().max(1.0);
        if count.is_nan() || count > super::MOST_CROSSINGS {
            return None;
        }
        let options = course.options(Integrator::Taylor);
        let map = PeriodMap::new(&ready.states, &ready.right, &ready.values, period, &options)?;
        Some(Self {
            map,
            solver: ready.solver,
            period,
            section: [before as usize, count as usize],
            step_limit: course.step_limit,
        })
    }

    /// The neighbourhoods of the attractors that motions have newly come to.
    fn learn(&self, motions: &[StartedMotion], largest: f64, known: &mut Vec<Known>) {
        let basins = Basins::of_members(&members(motions), largest);
        let followed = || {
            motions.iter().filter_map(|motion| match motion {
                StartedMotion::Followed(motion) => Some(motion.as_ref()),
                StartedMotion::Joins(..) => None,
            })
        };
        let sizes = least_extents(&followed().collect::<Vec<_>>(), largest);
        for own in known.iter_mut() {
            own.sizes.clone_from(&sizes);
        }
        for index in 0..basins.attractors.len() {
            let own = |fate: &Fate| *fate == Fate::Settled(index);
            let Some(motion) = basins.fates.iter().position(own) else { continue };
            let StartedMotion::Followed(first) = &motions[motion] else { continue };
            let Some(last) = first.crossings.last() else { continue };
            if known.iter().all(|known| known.motion != motion) {
                let states = &basins.attractors[index].states;
                // What has not quite settled on one state may pass for a cycle of several that are one.
                let neighbourhood = match are_distinct(states, &sizes) {
                    true => Neighbourhood::new(&self.map, &last.state, states.len(), &sizes),
                    false => None,
                };
                known.push(Known { motion, neighbourhood, sizes: sizes.clone() });
            }
        }
    }

    /// The number of the motion whose attractor each of these joins; `None` for those that come near none in a
    /// quarter of the time.
    fn joined(
        &self,
        course: &TrajectoryRequest,
        names: &[Symbol],
        starts: &[Vec<f64>],
        known: &[Known],
    ) -> Vec<Option<usize>> {
        let most = self.section[1] / 4 / LOOK;
        let begin = |(index, start): (usize, &Vec<f64>)| {
            let course = course_at(course, names, start);
            course.check_start().is_ok().then_some(LookedAt {
                index,
                state: course.start,
                steps: 0,
            })
        };
        let mut going: Vec<LookedAt> = starts.iter().enumerate().filter_map(begin).collect();
        let mut joined = vec![None; starts.len()];
        for look in 0..most {
            let size = going.len().div_ceil(threads()).clamp(1, LANES);
            let groups: Vec<&[LookedAt]> = going.chunks(size).collect();
            let looked = par_map(&groups, |group| self.look(group, look * LOOK, known));
            let mut next = Vec::with_capacity(going.len());
            for (motion, found) in going.iter().zip(looked.into_iter().flatten()) {
                match found {
                    Look::Joins(earlier) => joined[motion.index] = Some(earlier),
                    Look::GoesOn(state, steps) => {
                        next.push(LookedAt { index: motion.index, state, steps });
                    }
                    Look::Ends => {}
                }
            }
            going = next;
        }
        joined
    }

    /// Follows motions from one look to the next; `before` states on the section have been passed.
    fn look(&self, group: &[LookedAt], before: usize, known: &[Known]) -> Vec<Look> {
        let until = LOOK as f64 * self.period;
        let flights: Vec<_> = group
            .iter()
            .map(|motion| (&self.solver, [0.0, until], motion.state.as_slice()))
            .collect();
        let looked = |(motion, path): (&LookedAt, Result<Path, _>)| {
            let Some(path) = path.ok().filter(|path| path.reason() == PathEnd::Reached) else {
                return Look::Ends;
            };
            let steps = motion.steps + path.step_count();
            for passed in 1..=LOOK {
                let time = self.period * passed as f64;
                let Some(state) = path.states_at(time.min(path.end())) else { continue };
                let number = before + passed;
                // As many steps as it took up to here, twice over, are allowed for it.
                let enough = 2 * steps / number * self.section[1] <= self.step_limit;
                let own = known.iter().find(|known| enough && self.joins(&state, number, known));
                if let Some(known) = own {
                    return Look::Joins(known.motion);
                }
            }
            Look::GoesOn(path.last_states().to_vec(), steps)
        };
        let paths = SideBySide::default().solve(&flights);
        group.iter().zip(paths).map(looked).collect()
    }

    /// Whether a motion that has this state, of this number on the section, settles on an attractor before the end.
    fn joins(&self, state: &[f64], number: usize, known: &Known) -> bool {
        let Some(neighbourhood) = &known.neighbourhood else { return false };
        let Some(distance) = neighbourhood.distance(state) else { return false };
        // As in the test of settling: the last third of the differences of states, the first of which is this.
        let n = neighbourhood.returns_after;
        let [first, last] = self.section;
        let third = (last + 1).saturating_sub(first + n) / 2;
        let Some(begin) = (last + 1).checked_sub(third + n).filter(|begin| *begin >= number) else {
            return false;
        };
        let distance = neighbourhood.distance_after((begin - number) / n, distance);
        let Some(contraction) = neighbourhood.contraction(distance) else { return false };
        let shrinks = contraction.powf((third / n) as f64);
        let now = 2.0 * neighbourhood.largest_change(distance, &known.sizes);
        third.div_ceil(n) as f64 * now * shrinks <= SETTLED * SAME * (1.0 - shrinks)
    }
}

/// Whether no two of these states are the same.
fn are_distinct(states: &[Vec<f64>], sizes: &[f64]) -> bool {
    let is_same = |one: &[f64], other: &[f64]| {
        one.iter().zip(other).zip(sizes).all(|((a, b), size)| (a - b).abs() <= SAME * size)
    };
    states.iter().enumerate().all(|(k, one)| states[..k].iter().all(|other| !is_same(one, other)))
}

/// A motion that is looked at.
struct LookedAt {
    /// Its number among those that are looked at together.
    index: usize,
    state: Vec<f64>,
    steps: usize,
}

/// The course of a motion as the section shows it.
enum Look {
    /// It settles on the attractor of the motion of this number.
    Joins(usize),
    /// It has come to these states, in so many steps.
    GoesOn(Vec<f64>, usize),
    /// It ends.
    Ends,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;
    use crate::oscillator::Oscillator;

    fn course(equation: &str, period: &str, [after, until]: [f64; 2]) -> TrajectoryRequest {
        let oscillator = Oscillator::parse(equation).expect("an equation");
        let mut course = TrajectoryRequest::of_equation(&oscillator);
        course.section = Some(PoincareSection::Every(parse_expression(period).expect("a period")));
        (course.after, course.duration) = (after, until);
        course
    }

    fn plane(size: f64, count: i32) -> Vec<Vec<f64>> {
        let place = |index: i32| size * (2.0 * f64::from(index) / f64::from(count - 1) - 1.0);
        (0..count).flat_map(|x| (0..count).map(move |v| vec![place(x), place(v)])).collect()
    }

    /// Motions that end early have the fates that they have when they are followed to the end: with one or two
    /// states of an attractor, where some do not settle by the end, and without a drive.
    #[test]
    fn fates_are_those_of_whole_motions() {
        let names = ["x".into(), "x'".into()];
        let forced = "x'' + x'/10 + x + x^3 = 0.3*cos(1.5*t)";
        // The least number of states of the attractors together, and the largest part that is followed.
        let cases = [
            (forced, "2*pi/1.5", [400.0, 500.0], 3.0, 2, 0.5),
            (forced, "2*pi/1.5", [60.0, 180.0], 3.0, 0, 1.0),
            ("x'' + 0.3*x' - x + x^3 = 0.28*cos(1.2*t)", "2*pi/1.2", [300.0, 500.0], 1.5, 2, 1.0),
            ("x'' + x'/5 - x + x^3 = 0", "1", [150.0, 200.0], 1.5, 2, 0.5),
            ("x'' + x'/5 + x + abs(x)*x = cos(t)", "2*pi", [150.0, 250.0], 1.5, 1, 1.0),
        ];
        for (equation, period, times, size, states, part) in cases {
            let course = course(equation, period, times);
            let grid = plane(size, 12);
            let whole = sweep(&course, &names, &grid, || ()).expect("motions");
            let expected = Basins::new(&whole);
            let found = sweep_to_attractors(&course, &names, &grid, || ()).expect("motions");
            assert_eq!(found.starts, grid, "{equation}");
            assert_eq!(found.basins, expected, "{equation}");
            let all: usize = found.basins.attractors.iter().map(|own| own.states.len()).sum();
            assert!(all >= states, "{equation}: {all}");
            let followed = found.followed as f64 / grid.len() as f64;
            assert!(followed <= part, "{equation}: {followed}");
            assert!(found.ended.is_empty());
        }
    }

    /// Two states closer than a thousandth of their extent are one.
    #[test]
    fn states_are_told_apart_by_their_extents() {
        let states = |apart: f64| [vec![1.0, 5.0], vec![2.0, 5.0], vec![1.0, 5.0 + apart]];
        assert!(are_distinct(&states(0.0201), &[1.0, 20.0]));
        assert!(!are_distinct(&states(0.0199), &[1.0, 20.0]));
    }

    /// What an interrupt leaves are the starts that were followed.
    #[test]
    fn an_interrupt_leaves_what_was_followed() {
        static STOP: std::sync::atomic::AtomicBool = std::sync::atomic::AtomicBool::new(true);
        let mut course = course("x'' + x'/5 - x + x^3 = 0", "1", [150.0, 200.0]);
        course.interrupt = crate::interrupt::Interrupt::from_flag(&STOP);
        let found =
            sweep_to_attractors(&course, &["x".into(), "x'".into()], &plane(1.0, 12), || ());
        assert!(found.expect("no error").starts.is_empty());
    }
}

//! Many motions of one equation, for a sequence of values of parameters or initial values; each
//! motion is recorded by its points on a section.
//!
//! In: a [`TrajectoryRequest`] and the values of some of its names. Out: a [`SweptMotion`] each, in
//! their order, independent of the number of threads; after an interrupt, only the motions that
//! were begun. With a [`Section`](super::Section) once a period, the points of a bifurcation
//! diagram.

use super::event_run::PieceKeeping;
use super::{Crossing, PoincareSection, TrajectoryError, TrajectoryRequest};
use crate::parallel::{par_map, threads};
use crate::symbol::Symbol;
use crate::system::{Integrator, LANES, PathEnd};

/// The record of one motion of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweptMotion {
    /// The values of the varied names, in their order.
    pub values: Vec<f64>,
    /// The time at which it ended.
    pub end: f64,
    /// Coordinates, then velocities there.
    pub state: Vec<f64>,
    /// The least and the greatest value of each coordinate, from the time `after` of the course on.
    pub extremes: Vec<[f64; 2]>,
    /// The states on the section from then on; none without a section.
    pub crossings: Vec<Crossing>,
    /// The times from then on at which it touches the section without crossing it.
    pub touches: Vec<f64>,
    /// The number of impacts on walls from then on.
    pub impacts: usize,
    /// The number of events from then on.
    pub events: usize,
    /// The reason why it ended.
    pub reason: PathEnd,
}

/// Follows the course at every one of the values; `progress` is called after each motion. The cost
/// is that of the motions, or less where eight of them are integrated side by side, on all cores.
/// After an interrupt no other motion is begun; those that have passed the time `after` are
/// returned. No energy is accounted for: each motion is bit for bit that of the course without
/// its `energy`.
///
/// # Errors
/// The number, counted from zero, of the first motion that cannot begin, and the reason.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::Oscillator;
/// use lindstedt::trajectory::{TrajectoryRequest, sweep};
///
/// let mut course = TrajectoryRequest::of_equation(&Oscillator::parse("x'' + k*x = 0")?);
/// course.begin("x'".into(), 1.0)?;
/// let motions = sweep(&course, &["k".into()], &[vec![1.0], vec![4.0]], || ()).map_err(|(_, error)| error)?;
/// assert!((motions[1].extremes[0][1] - 0.5).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep(
    course: &TrajectoryRequest,
    names: &[Symbol],
    grid: &[Vec<f64>],
    progress: impl Fn() + Sync,
) -> Result<Vec<SweptMotion>, (usize, TrajectoryError)> {
    let at = |values: &[f64]| course_at(course, names, values);
    // The equations are compiled once, if possible, and take other numbers for each motion.
    let ready = grid.first().and_then(|first| at(first).ready(Integrator::Taylor).ok());
    // The states on a section are those of pieces; the least and the greatest values are found on the way.
    let keeping = match course.section {
        Some(_) => PieceKeeping::All,
        None => PieceKeeping::ranges(course.coordinates.len()),
    };
    // Motions are integrated side by side on each thread, and on all threads.
    let size = grid.len().div_ceil(threads()).clamp(1, LANES);
    let numbered: Vec<_> = grid.iter().enumerate().collect();
    let together = |group: &&[(usize, &Vec<f64>)]| {
        if course.interrupt.is_requested() {
            return Ok(vec![]);
        }
        let courses = group.iter().map(|(_, values)| at(values)).collect();
        let motions = TrajectoryRequest::followed_together(courses, ready.as_ref(), &keeping);
        let mut swept = Vec::with_capacity(group.len());
        for ((number, values), motion) in group.iter().zip(motions) {
            let motion = motion.map_err(|error| (*number, error))?;
            progress();
            // A motion that was interrupted before the time `after`, or before its first step, is
            // left out.
            let end = motion.end();
            if motion.reason() == PathEnd::Interrupted && (end < course.after || end == 0.0) {
                continue;
            }
            swept.push(SweptMotion {
                values: values.to_vec(),
                end,
                state: motion.states_at(end).unwrap_or_default(),
                extremes: motion.extremes(),
                crossings: motion.crossings().to_vec(),
                touches: motion.touches().to_vec(),
                impacts: motion.walls.impacts.iter().filter(|hit| hit.time >= course.after).count(),
                events: {
                    let events = motion.events.occurrences.iter();
                    events.filter(|event| event.time >= course.after).count()
                },
                reason: motion.reason(),
            });
        }
        Ok(swept)
    };
    let groups: Vec<_> = numbered.chunks(size).collect();
    let motions: Result<Vec<Vec<SweptMotion>>, _> =
        par_map(&groups, together).into_iter().collect();
    Ok(motions?.into_iter().flatten().collect())
}

/// The course at these values of the names.
pub(super) fn course_at(
    course: &TrajectoryRequest,
    names: &[Symbol],
    values: &[f64],
) -> TrajectoryRequest {
    // The energies of a sweep are not used, and nothing before the time `after` but by a section
    // on which a motion may turn back, which looks at all of its turns.
    let keep_from = match course.section {
        Some(PoincareSection::Rising(_)) => f64::NEG_INFINITY,
        Some(PoincareSection::Every(_) | PoincareSection::Impacts | PoincareSection::Events)
        | None => course.after,
    };
    let mut course = TrajectoryRequest { energy: None, keep_from, ..course.clone() };
    for (name, value) in names.iter().zip(values) {
        match course.rates.states.iter().position(|state| state == name) {
            Some(place) => course.start[place] = *value,
            None => {
                course.values.insert(*name, *value);
            }
        }
    }
    course
}

//! The events of a step in the simple case: at most one turning point, and at most one crossing of
//! a bound after or before it, found for several motions side by side.
//!
//! The bounds of x are the barriers; the bound of w, in contact, is 0. Other steps are analysed
//! motion by motion, by `flight` and `contact`, which give the same numbers in the simple case.

use super::series::{Ends, Inputs, SeriesCoefficients};
use super::{StepEquation, VANISHING};
use crate::impact::polynomial::lanes::{changes_of_sign, crossings};

/// A point within a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StepPoint {
    /// The variable of the series.
    pub(super) at: f64,
    /// x or w.
    pub(super) place: f64,
    pub(super) velocity: f64,
    /// Since the start of the step.
    pub(super) time: f64,
}

/// The events in a step of one motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StepEvents {
    pub(super) turn: Option<StepPoint>,
    /// The point at which a bound is crossed, and whether it is the upper one.
    pub(super) crossing: Option<(StepPoint, bool)>,
}

/// The events in a step of several motions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Courses<const L: usize> {
    plain: [bool; L],
    turns: [bool; L],
    turn: Points<L>,
    crosses: [bool; L],
    rises: [bool; L],
    crossing: Points<L>,
}

#[derive(Debug, Clone, Copy)]
struct Points<const L: usize> {
    at: [f64; L],
    place: [f64; L],
    velocity: [f64; L],
    time: [f64; L],
}

impl<const L: usize> Points<L> {
    fn new() -> Self {
        Self { at: [0.0; L], place: [0.0; L], velocity: [0.0; L], time: [0.0; L] }
    }

    fn lane(&self, lane: usize) -> StepPoint {
        StepPoint {
            at: self.at[lane],
            place: self.place[lane],
            velocity: self.velocity[lane],
            time: self.time[lane],
        }
    }
}

impl<const L: usize> Courses<L> {
    /// No events in any of the steps.
    pub(super) fn new() -> Self {
        Self {
            plain: [true; L],
            turns: [false; L],
            turn: Points::new(),
            crosses: [false; L],
            rises: [false; L],
            crossing: Points::new(),
        }
    }

    /// The events of one motion; `None` if its case is not simple.
    pub(super) fn lane(&self, lane: usize) -> Option<StepEvents> {
        self.plain[lane].then(|| StepEvents {
            turn: self.turns[lane].then(|| self.turn.lane(lane)),
            crossing: self.crosses[lane].then(|| (self.crossing.lane(lane), self.rises[lane])),
        })
    }
}

/// The events of steps of these lengths.
#[inline(always)]
pub(super) fn courses<const L: usize>(
    series: &SeriesCoefficients<L>,
    (order, equation): (usize, StepEquation),
    inputs: &Inputs<L>,
    lengths: &[f64; L],
    ends: &Ends<L>,
    courses: &mut Courses<L>,
) {
    (courses.plain, courses.turns) = ([true; L], [false; L]);
    let (place, velocity) = (&series.place[..=order], &series.velocity[..=order]);
    // Start and end of the part of the step that may cross a bound.
    let (mut from, mut start) = ([0.0; L], inputs.place);
    let (mut to, mut goal) = (*lengths, ends.place);
    let may_turn: [bool; L] = std::array::from_fn(|lane| {
        (inputs.velocity[lane].abs() <= ends.variation[lane]) & (ends.variation[lane] >= VANISHING)
    });
    if may_turn.contains(&true) {
        let changes = changes_of_sign(velocity, lengths);
        for lane in 0..L {
            let opposite = inputs.velocity[lane] * ends.velocity[lane] < 0.0;
            let same = inputs.velocity[lane] * ends.velocity[lane] > 0.0;
            courses.turns[lane] = may_turn[lane] & (changes[lane] == 1.0) & opposite;
            courses.plain[lane] =
                courses.turns[lane] | !may_turn[lane] | (changes[lane] == 0.0) & same;
        }
    }
    if courses.turns.contains(&true) {
        let turn = crossings(
            velocity,
            &[0.0; L],
            (&[0.0; L], &inputs.velocity),
            (lengths, &ends.velocity),
            &courses.turns,
        );
        courses.turn.at = turn;
        let [turn_place, _, turn_time] = series.values(&turn, order, equation);
        (courses.turn.place, courses.turn.time) = (turn_place, turn_time);
        for lane in 0..L {
            let turned = courses.turn.place[lane];
            let beyond = (turned > inputs.upper[lane]) | (turned < inputs.lower[lane]);
            // A crossing of a bound ends the step before the turning point beyond it.
            let (ends, begins) = (courses.turns[lane] & beyond, courses.turns[lane] & !beyond);
            to[lane] = if ends { turn[lane] } else { to[lane] };
            goal[lane] = if ends { turned } else { goal[lane] };
            from[lane] = if begins { turn[lane] } else { from[lane] };
            start[lane] = if begins { turned } else { start[lane] };
            courses.turns[lane] = begins;
        }
    }
    let mut level = [0.0; L];
    for lane in 0..L {
        let (rises, falls) = (goal[lane] > inputs.upper[lane], goal[lane] < inputs.lower[lane]);
        courses.rises[lane] = rises;
        courses.crosses[lane] = rises | falls;
        level[lane] = if rises { inputs.upper[lane] } else { inputs.lower[lane] };
        let inside = (start[lane] < inputs.upper[lane]) & (start[lane] > inputs.lower[lane]);
        let at_bound = (goal[lane] == inputs.upper[lane]) | (goal[lane] == inputs.lower[lane]);
        courses.plain[lane] &= !at_bound & (inside | !courses.crosses[lane]);
    }
    if courses.crosses.contains(&true) {
        for lane in 0..L {
            start[lane] -= level[lane];
            goal[lane] -= level[lane];
        }
        let crossing = crossings(place, &level, (&from, &start), (&to, &goal), &courses.crosses);
        courses.crossing.at = crossing;
        [courses.crossing.place, courses.crossing.velocity, courses.crossing.time] =
            series.values(&crossing, order, equation);
    }
}

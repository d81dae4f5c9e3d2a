//! The true motion near a solution of the balance, and its stability by Floquet's multipliers.
//!
//! ```text
//! M' = [0 1; -f_x -f_v] M,  M(0) = 1:   the multipliers are the eigenvalues of M(T),   det M(T) = exp(-integral of f_v over T)
//! ```
//!
//! In: a start near a motion of period T. Out: the motion itself, found by shooting (Newton's
//! method for the start that comes back after a period), its first harmonic and its peaks, and its
//! multipliers; it is stable if both lie inside the unit circle (A. H. Nayfeh and B. Balachandran,
//! *Applied Nonlinear Dynamics*, Wiley 1995, chapters 3 and 6). Everything is integrated on the
//! equation as it was given, by Taylor series, or by Runge-Kutta where it has none; only the start is
//! taken from the balance.

use nalgebra::{Matrix2, Vector2};
use num_complex::Complex;

use super::driven::{Driven, TimedStart};
use super::jump::{StopCondition, VariationalMotion, evaluations_of, follow, positions_on};
use crate::interrupt::Interrupt;
use crate::numeric::ode::{
    Action, Event, IntegrationOptions, Point, StopReason, Trajectory, integrate_first_order,
};
use crate::numeric::periodic::{PeriodicOrbit, SearchStep, Shooting, eigenvalues_of_two};
use crate::system::{LANES, Path};

/// Number of samples of a period for its harmonics and peaks.
pub(super) const SAMPLES: usize = 256;

/// Number of samples of an orbit that meets corners: harmonics beyond half of them are added to the
/// lower ones.
pub(super) const ORBIT_SAMPLES: usize = 1024;

/// The monodromy matrix: the image of a small disturbance of a periodic motion after one period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floquet {
    /// M(T).
    pub monodromy: Matrix2<f64>,
    /// Whether nothing drives the motion: M(T) is then diagonal, and its second multiplier, along
    /// the motion, is 1.
    pub self_excited: bool,
}

impl Floquet {
    /// The eigenvalues of M(T), the larger first; for a self-excited motion the nontrivial one,
    /// then the one that is 1.
    pub fn multipliers(&self) -> [Complex<f64>; 2] {
        match self.self_excited {
            true => [self.monodromy[(0, 0)], 1.0].map(Complex::from),
            false => eigenvalues_of_two(self.monodromy.trace(), self.monodromy.determinant()),
        }
    }

    /// The absolute value of the multiplier that decides about stability, the larger one.
    pub fn largest(&self) -> f64 {
        self.multipliers()[0].norm()
    }
}

/// A periodic motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueMotion {
    /// Position and velocity at phase zero.
    pub start: [f64; 2],
    /// Its frequency.
    pub frequency: f64,
    /// The multipliers.
    pub floquet: Floquet,
    /// Coefficients of cos(theta) and sin(theta).
    pub first_harmonic: [f64; 2],
    /// Half of the way from the lowest to the highest point.
    pub peak: f64,
    /// The fraction of the period during which the motion sticks.
    pub stuck: f64,
}

impl TrueMotion {
    /// A motion from its positions over a period at equal steps.
    pub(super) fn new(
        start: [f64; 2],
        frequency: f64,
        floquet: Floquet,
        positions: &[f64],
        stuck: f64,
    ) -> Self {
        let first_harmonic = first_harmonic(positions);
        Self {
            start,
            frequency,
            floquet,
            first_harmonic,
            peak: half_of_peak_to_peak(positions),
            stuck,
        }
    }
}

/// Relative tolerance of a step in verification.
pub(super) const TOLERANCE: f64 = 1e-10;

/// Largest number of steps of a period.
const STEPS: usize = 4_000;

pub(super) fn options(size: f64, tolerance: f64) -> IntegrationOptions {
    IntegrationOptions {
        absolute_tolerance: tolerance * size.clamp(1e-12, 1.0),
        maximum_steps: STEPS,
        ..IntegrationOptions::with_tolerance(tolerance)
    }
}

/// Largest change of the start by shooting, relative to the size of the motion, and of the period.
pub(super) const FAR: f64 = 0.3;

/// A test whether shooting has converged, from the closure error of an orbit and the size of the
/// next Newton step.
pub(super) fn convergence_test(closely: f64) -> impl FnMut(f64, f64) -> bool {
    let mut before = f64::INFINITY;
    move |missed, moved| {
        // Near a fold rounding is magnified: steps that no longer shrink have converged.
        let stalled = moved <= 1e-6 && moved >= 0.5 * before;
        before = moved;
        stalled || moved <= closely || missed <= 1e-12
    }
}

/// A guess of a driven periodic motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionGuess {
    /// Position and velocity at phase zero.
    pub start: [f64; 2],
    /// The parameter.
    pub parameter: f64,
    /// The approximate amplitude.
    pub size: f64,
}

/// The periodic motion whose start is near this one; `None` if shooting does not converge, or moves
/// far away.
pub fn periodic_motion(driven: &Driven, guess: MotionGuess) -> Option<TrueMotion> {
    periodic_motions(driven, &[guess]).pop().flatten()
}

/// The periodic motions near several guesses, as [`periodic_motion`] finds each; they are followed
/// side by side where they have Taylor series.
///
/// A motion costs two to four periods with their variations; eight side by side cost little more
/// than one.
pub fn periodic_motions(driven: &Driven, guesses: &[MotionGuess]) -> Vec<Option<TrueMotion>> {
    let shooting = |guess: &MotionGuess| {
        let omega = driven.frequency_at(guess.parameter);
        Shooting {
            guess: guess.start,
            period: std::f64::consts::TAU / omega,
            rates: None,
            sizes: [guess.size, guess.size * omega],
            solve: |matrix, missed| matrix.lu().solve(&missed),
            most: 12,
            far: FAR,
            known: &[],
        }
    };
    let shootings: Vec<Shooting<2>> = guesses.iter().map(shooting).collect();
    let mut searches: Vec<_> = shootings.iter().map(Shooting::begin).collect();
    let mut tests: Vec<_> = guesses.iter().map(|_| convergence_test(1e-9)).collect();
    let mut found: Vec<Option<TrueMotion>> = vec![None; guesses.len()];
    let mut going: Vec<usize> = (0..guesses.len()).collect();
    while !going.is_empty() {
        let motion = |index: &usize| TimedStart {
            start: searches[*index].start(),
            begin: 0.0,
            parameter: guesses[*index].parameter,
            duration: searches[*index].period(),
        };
        let motions: Vec<TimedStart> = going.iter().map(motion).collect();
        let mut followed = followed_together(driven, &motions).into_iter();
        going.retain(|&index| {
            let Some(course) = followed.next().flatten() else { return false };
            let [x, v, variations @ ..] = course.end;
            let image = ([x, v], Matrix2::from_column_slice(&variations), course);
            match searches[index].advance(image, &mut tests[index]) {
                SearchStep::Going => true,
                SearchStep::Failed => false,
                SearchStep::Found(PeriodicOrbit { start, monodromy, path, .. }) => {
                    let omega = driven.frequency_at(guesses[index].parameter);
                    let floquet = Floquet { monodromy, self_excited: false };
                    let (positions, stuck) = (path.positions(SAMPLES), path.stuck());
                    found[index] = Some(TrueMotion::new(start, omega, floquet, &positions, stuck));
                    false
                }
            }
        });
    }
    found
}

/// Several motions with their variations, by Taylor series side by side, or each by itself where it
/// has none; `None` for one that cannot be followed.
fn followed_together(driven: &Driven, motions: &[TimedStart]) -> Vec<Option<VariationalMotion>> {
    let paths = driven.varied_by_series(motions);
    let course = |(path, motion): (Option<Path>, &TimedStart)| match path {
        Some(path) => VariationalMotion::from_series(path),
        None => {
            let &TimedStart { start, parameter, duration, .. } = motion;
            let omega = driven.frequency_at(parameter);
            let options = options(start[0].abs().max(start[1].abs() / omega), TOLERANCE);
            follow(driven, start, parameter, StopCondition::Time(duration), &options)
        }
    };
    paths.into_iter().zip(motions).map(course).collect()
}

/// The multipliers of a motion that is given with its frequency, not followed: `motion` has
/// position and velocity at a phase.
pub fn multipliers_along(
    driven: &Driven,
    parameter: f64,
    omega: f64,
    motion: impl Fn(f64) -> [f64; 2],
) -> Option<Floquet> {
    let rates = |t: f64, y: &[f64; 4], rates: &mut [f64; 4]| {
        let [position, velocity] = motion(omega * t);
        let [by_position, by_velocity, _] =
            driven.slopes(&[position, velocity, omega * t, parameter]);
        *rates = [
            y[1],
            -by_position * y[0] - by_velocity * y[1],
            y[3],
            -by_position * y[2] - by_velocity * y[3],
        ];
    };
    let begin = Point { t: 0.0, y: [1.0, 0.0, 0.0, 1.0] };
    let path = integrate_first_order(
        rates,
        begin,
        std::f64::consts::TAU / omega,
        &[],
        &options(1.0, TOLERANCE),
    )
    .ok()?;
    let end = path.end().y;
    path.is_complete().then_some(Floquet {
        monodromy: Matrix2::new(end[0], end[2], end[1], end[3]),
        self_excited: false,
    })
}

/// Coefficients of cos(theta) and sin(theta) of a period in equal steps.
pub fn first_harmonic(positions: &[f64]) -> [f64; 2] {
    let count = positions.len() as f64;
    let mut sums = [0.0; 2];
    for (index, position) in positions.iter().enumerate() {
        let (sine, cosine) = (std::f64::consts::TAU * index as f64 / count).sin_cos();
        sums[0] += position * cosine;
        sums[1] += position * sine;
    }
    sums.map(|sum| 2.0 * sum / count)
}

/// Half of the way from the lowest to the highest point of a period in equal steps, by the parabola
/// through three of them.
pub fn half_of_peak_to_peak(positions: &[f64]) -> f64 {
    let count = positions.len();
    let top = |sign: f64| {
        let highest = (0..count)
            .max_by(|one, other| (sign * positions[*one]).total_cmp(&(sign * positions[*other])));
        let Some(middle) = highest else {
            return 0.0;
        };
        let value = |offset: usize| sign * positions[(middle + offset) % count];
        let [before, here, after] = [value(count - 1), value(0), value(1)];
        let curvature = before - 2.0 * here + after;
        match curvature < 0.0 {
            true => here - (after - before).powi(2) / (8.0 * curvature),
            false => here,
        }
    };
    0.5 * (top(1.0) + top(-1.0))
}

/// Half of the way from the lowest to the highest point of a path by series, from its turning
/// points; `None` if it does not turn twice.
pub(super) fn half_of_travel(path: &Path) -> Option<f64> {
    let turns = path.zeros(1, 0.0)?;
    let positions = turns.iter().filter_map(|time| path.state_at(*time, 0));
    // A turn at the very ends may be missed by rounding, and is their position.
    let ends = [path.state_at(0.0, 0)?, path.state_at(path.end(), 0)?];
    let [low, high] = positions
        .chain(ends)
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    (turns.len() >= 2).then_some(0.5 * (high - low))
}

/// The motion near an orbit that was found by series, followed over a period in time by a
/// Runge-Kutta method, which evaluates the force as it was given and uses no series; it begins where
/// one step of Newton's method puts the closed orbit. Where that is not close, the motion is
/// followed once more with finer steps. `None` if it cannot be followed.
///
/// A step ends at every corner of the force, so that the touch of a stop is not stepped over. A touch
/// costs some 20 to 60 steps of 16 evaluations, hardly dependent on the stiffness.
pub fn checked_orbit(driven: &Driven, orbit: &TrueMotion, parameter: f64) -> Option<TrueMotion> {
    /// Tolerance of a step where the motion does not close: beside a grazing one small errors grow
    /// a thousand times, and a touch may be so short that it hides between two steps.
    const FINEST: f64 = 1e-2 * TOLERANCE;
    /// Ratio to the size of the distance of the closed orbit above which the finer steps count.
    const CLOSE: f64 = 1e-6;
    let ([x, v], omega) = (orbit.start, orbit.frequency);
    let followed = |tolerance: f64| {
        let legs = legs_of_a_period(driven, orbit, parameter, tolerance)?;
        let end = legs.last()?.end().y;
        let missed = Vector2::new(end[0] - x, end[1] - v);
        let away = Matrix2::identity() - orbit.floquet.monodromy;
        let step = away.lu().solve(&missed)?;
        Some((legs, end, step))
    };
    let is_close = |step: &Vector2<f64>| step[0].hypot(step[1] / omega) <= CLOSE * orbit.peak;
    let (legs, end, step) = match followed(TOLERANCE) {
        Some(found) if is_close(&found.2) => found,
        first => followed(FINEST).or(first)?,
    };
    let time = |sample: usize| std::f64::consts::TAU / omega * sample as f64 / ORBIT_SAMPLES as f64;
    let mut leg = 0;
    let position = |sample: usize| {
        while leg + 1 < legs.len() && time(sample) >= legs[leg].end().t {
            leg += 1;
        }
        Some(legs[leg].state_at(time(sample))?.y[0])
    };
    let positions: Vec<f64> = (0..ORBIT_SAMPLES).map_while(position).collect();
    if positions.len() < ORBIT_SAMPLES {
        return None;
    }
    let start = [x + step[0], v + step[1]];
    let truth = TrueMotion::new(start, omega, orbit.floquet, &positions, 0.0);
    let turns = legs.iter().flat_map(|leg| leg.occurrences()).filter(|turn| turn.event == 0);
    let [low, high] = turns
        .map(|turn| turn.state.y[0])
        .chain([x, end[0]])
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    Some(TrueMotion { peak: 0.5 * (high - low), ..truth })
}

/// A period of a motion by Runge-Kutta, leg by leg between the corners of the force; the first event
/// of each leg is a turning point. `None` if it cannot be followed.
fn legs_of_a_period(
    driven: &Driven,
    orbit: &TrueMotion,
    parameter: f64,
    tolerance: f64,
) -> Option<Vec<Trajectory<Point<[f64; 2]>>>> {
    /// Largest number of legs.
    const MOST: usize = 400;
    /// Part of the period behind a corner within which the same corner is not met once more: there its
    /// expression is rounding.
    const BEHIND: f64 = 1e-9;
    let rates = |t: f64, y: &[f64; 2], rates: &mut [f64; 2]| {
        *rates = [y[1], -driven.force_in_time(&[y[0], y[1], t, parameter])];
    };
    let turns = || Event::new(|point: &Point<[f64; 2]>| point.y[1], Action::Record);
    let period = std::f64::consts::TAU / orbit.frequency;
    let corner = |(index, met): (usize, &f64)| {
        let seen_from = met + BEHIND * period;
        let guard = move |point: &Point<[f64; 2]>| match point.t < seen_from {
            true => 0.0,
            false => driven.corner(index, &[point.y[0], point.y[1], point.t, parameter]),
        };
        Event::new(guard, Action::Stop)
    };
    // The time at which each corner was met last.
    let mut met = vec![f64::NEG_INFINITY; driven.corners()];
    let options = options(orbit.peak, tolerance);
    let mut begin = Point { t: 0.0, y: orbit.start };
    let mut legs = Vec::new();
    for _ in 0..MOST {
        let events: Vec<_> =
            [turns()].into_iter().chain(met.iter().enumerate().map(corner)).collect();
        let leg = integrate_first_order(rates, begin, period, &events, &options).ok()?;
        if !leg.is_complete() {
            return None;
        }
        begin = leg.end();
        // The first event is the turn.
        if let StopReason::Event { event, .. } = leg.stop_reason()
            && let Some(met) = event.checked_sub(1).and_then(|index| met.get_mut(index))
        {
            *met = begin.t;
        }
        legs.push(leg);
        if begin.t >= period {
            return Some(legs);
        }
    }
    None
}

/// The budget of several simulations together: the evaluations of the force that are left, and the
/// interrupt.
#[derive(Clone, Copy, Debug)]
pub struct SimulationBudget {
    /// Number of evaluations left.
    pub evaluations: usize,
    /// The interrupt, tested after every period.
    pub interrupt: Interrupt,
}

impl SimulationBudget {
    /// Subtracts the cost of a period. Returns whether another one may be computed.
    pub(super) fn spend(&mut self, evaluations: usize) -> bool {
        self.evaluations = self.evaluations.saturating_sub(evaluations);
        self.evaluations > 0 && !self.interrupt.is_requested()
    }
}

/// The steady state that a simulation has reached.
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    /// Position and velocity at phase zero.
    pub state: [f64; 2],
    /// The number of periods after which it repeats itself, or will once a decaying transient is
    /// gone; `None` if it does not within eight.
    pub returns_after: Option<usize>,
    /// Its positions over the last period, at equal steps.
    pub positions: Vec<f64>,
    /// Half of the way from the lowest to the highest point.
    pub peak: f64,
    /// Places between two consecutive states that come near each other, the nearest first: guesses of
    /// the motions of one period that one of more periods, or chaos, surrounds.
    pub nearest_returns: Vec<[f64; 2]>,
}

/// A period of a simulation, in one piece or in legs between the jumps of the force.
enum Period {
    Series(Path),
    One(Trajectory<Point<[f64; 2]>>),
    Legs(VariationalMotion),
}

impl Period {
    /// Position and velocity at the end; `None` if it was not reached.
    fn end(&self) -> Option<[f64; 2]> {
        match self {
            Self::Series(path) => path.states_at(path.end())?.try_into().ok(),
            Self::One(path) => path.is_complete().then(|| path.end().y),
            Self::Legs(course) => Some([course.end[0], course.end[1]]),
        }
    }

    fn positions(&self, count: usize) -> Vec<f64> {
        match self {
            Self::Series(path) => positions_on(path, count),
            Self::One(path) => {
                path.samples(count + 1).take(count).map(|point| point.y[0]).collect()
            }
            Self::Legs(course) => course.positions(count),
        }
    }

    fn evaluations(&self) -> usize {
        match self {
            Self::Series(path) => evaluations_of(path),
            Self::One(path) => path.evaluations(),
            Self::Legs(course) => course.evaluations(),
        }
    }
}

/// A simulation that is to settle.
#[derive(Clone, Debug, PartialEq)]
pub struct SettlingStart {
    /// Position and velocity at phase zero.
    pub start: [f64; 2],
    /// The parameter.
    pub parameter: f64,
    /// The largest number of periods.
    pub most: usize,
    /// Starts of stable motions that are known at this value of the parameter: a simulation that comes close
    /// to one of them ends.
    pub known: Vec<MotionGuess>,
}

/// Follows the equation as it was given from several starts, period by period, each until it repeats
/// itself to `closely` (of its size), or its largest number of periods is over; the tolerance of a
/// step is a thousandth of that. Those that have Taylor series go side by side. `None` for one that
/// cannot be followed: it escapes, or the `budget` is spent; and for one that comes to a motion that is
/// known.
pub fn settle_together(
    driven: &Driven,
    starts: &[SettlingStart],
    closely: f64,
    budget: &mut SimulationBudget,
) -> Vec<Option<Settled>> {
    // Without series nothing is gained side by side, and a budget that is spent should leave the
    // first of them settled.
    let together = if driven.has_series() { 4 * LANES } else { 1 };
    let mut all = Vec::new();
    for starts in starts.chunks(together) {
        let mut runs: Vec<Settling> = starts.iter().map(Settling::new).collect();
        let mut going: Vec<usize> = (0..runs.len()).collect();
        while !going.is_empty() {
            let motions: Vec<TimedStart> =
                going.iter().map(|index| runs[*index].next_period(driven)).collect();
            let mut paths = driven.by_short_series(&motions).into_iter();
            going.retain(|&index| {
                let path = paths.next().flatten().map(Period::Series);
                runs[index].advance(driven, path, closely, budget)
            });
        }
        all.extend(runs.into_iter().map(|run| run.settled(driven)));
    }
    all
}

/// The distance below which two states that are so far from zero may differ by rounding alone.
fn rounding([x, v]: &[f64; 2], omega: f64) -> f64 {
    const PLACES: f64 = 64.0 * f64::EPSILON;
    PLACES * x.abs().max(v.abs() / omega)
}

/// Largest number of periods within which a motion may repeat itself.
const LONGEST: usize = 8;

/// A simulation in progress.
struct Settling {
    parameter: f64,
    known: Vec<MotionGuess>,
    /// The number of periods that are left.
    left: usize,
    /// The states at the beginning of each period.
    states: Vec<[f64; 2]>,
    /// The number of consecutive periods after which it has repeated itself.
    quiet: usize,
    /// Whether it repeats itself after more than one period.
    repeats: bool,
    last: Option<Period>,
}

impl Settling {
    fn new(start: &SettlingStart) -> Self {
        let &SettlingStart { start, parameter, most, ref known } = start;
        let known = known.clone();
        Self {
            parameter,
            known,
            left: most,
            states: vec![start],
            quiet: 0,
            repeats: false,
            last: None,
        }
    }

    fn next_period(&self, driven: &Driven) -> TimedStart {
        let duration = std::f64::consts::TAU / driven.frequency_at(self.parameter);
        let start = self.states[self.states.len() - 1];
        TimedStart { start, begin: 0.0, parameter: self.parameter, duration }
    }

    /// Takes a period, given by its series if it has one. Returns whether another one follows; a
    /// simulation that fails keeps no period.
    fn advance(
        &mut self,
        driven: &Driven,
        series: Option<Period>,
        closely: f64,
        budget: &mut SimulationBudget,
    ) -> bool {
        self.last = if self.left == 0 { None } else { self.taken(driven, series, closely, budget) };
        self.left = self.left.saturating_sub(1);
        if self.comes_to_known(driven.frequency_at(self.parameter)) {
            self.last = None;
        }
        self.last.is_some() && self.quiet < 3 && !self.repeats && self.left > 0
    }

    /// Whether the last three states come nearer and nearer to a stable motion that is known, and are
    /// close to it.
    fn comes_to_known(&self, omega: f64) -> bool {
        /// Ratio of the distance to the size of the motion, and to that of the start, if the motion is rest.
        const CLOSE: f64 = 1e-2;
        const CLOSE_TO_REST: f64 = 1e-4;
        let [first, .., one, two, three] = self.states.as_slice() else { return false };
        self.known.iter().any(|motion| {
            let distance = |state: &[f64; 2]| {
                let [x, v] = motion.start;
                (state[0] - x).hypot((state[1] - v) / omega)
            };
            let close = (CLOSE * motion.size).max(CLOSE_TO_REST * distance(first));
            let [one, two, three] = [one, two, three].map(distance);
            one > two && two > three && three <= close
        })
    }

    fn taken(
        &mut self,
        driven: &Driven,
        series: Option<Period>,
        closely: f64,
        budget: &mut SimulationBudget,
    ) -> Option<Period> {
        const BOUND: f64 = 1e8;
        let TimedStart { start: begin, parameter, duration, .. } = self.next_period(driven);
        let omega = driven.frequency_at(parameter);
        let size = begin[0].abs().max(begin[1].abs() / omega);
        let settings = options(size, (1e-3 * closely).clamp(1e-13, 1e-6));
        let path = if driven.jumps() > 0 {
            let until = StopCondition::Time(duration);
            Period::Legs(follow(driven, begin, parameter, until, &settings)?)
        } else if let Some(path) = series {
            path
        } else {
            let rates = |t: f64, y: &[f64; 2], rates: &mut [f64; 2]| {
                *rates = [y[1], -driven.force_in_time(&[y[0], y[1], t, parameter])];
            };
            let begin = Point { t: 0.0, y: begin };
            Period::One(integrate_first_order(rates, begin, duration, &[], &settings).ok()?)
        };
        let end = path.end()?;
        if !budget.spend(path.evaluations()) || size > BOUND {
            return None;
        }
        let moved = (end[0] - begin[0]).hypot((end[1] - begin[1]) / omega);
        let away = path.positions(32).into_iter().chain([end[0]]);
        let extent = away.fold(0.0_f64, |most, position| most.max((position - begin[0]).abs()));
        self.states.push(end);
        // A state of rest counts as periodic, also far from zero.
        let is_quiet = moved <= (closely * extent.max(1e-12)).max(rounding(&begin, omega));
        self.quiet = if is_quiet { self.quiet + 1 } else { 0 };
        self.repeats = self.repeats_later(omega, extent);
        Some(path)
    }

    /// Whether it has repeated itself, to a small part of this extent, after each of the last two times as many
    /// periods as it takes, which are more than one, and has been elsewhere in between.
    fn repeats_later(&self, omega: f64, extent: f64) -> bool {
        /// Parts of the extent below which states are one, and above which they are two.
        const SAME: f64 = 1e-7;
        const OTHER: f64 = 1e-2;
        let end = self.states.len() - 1;
        let apart = |index: usize, count: usize| {
            let [one, other] = [self.states[index], self.states[index - count]];
            (one[0] - other[0]).hypot((one[1] - other[1]) / omega)
        };
        let repeats = |count: usize| {
            end >= 3 * count
                && (0..2 * count).all(|back| apart(end - back, count) <= SAME * extent)
                && (1..count).all(|fewer| apart(end, fewer) >= OTHER * extent)
        };
        (2..=LONGEST).any(repeats)
    }

    /// The steady state; `None` if the simulation failed.
    fn settled(self, driven: &Driven) -> Option<Settled> {
        /// Number of periods over which the largest difference is taken, and the largest fraction
        /// of it that may remain a quarter of the run later.
        const WINDOW: usize = 16;
        const FALLING: f64 = 0.9;
        let Self { parameter, states, last, .. } = self;
        let omega = driven.frequency_at(parameter);
        let last = last?;
        let positions = last.positions(SAMPLES);
        let state = states.last().copied()?;
        // At a stiff stop a motion turns between two samples.
        let turns = match &last {
            Period::Series(path) if !driven.smooth => half_of_travel(path),
            _ => None,
        };
        let peak = turns.unwrap_or_else(|| half_of_peak_to_peak(&positions));
        let extent = peak.max(1e-12);
        let apart = |index: usize, count: usize| {
            let [one, other] = [states.get(index)?, states.get(index.checked_sub(count)?)?];
            Some((one[0] - other[0]).hypot((one[1] - other[1]) / omega))
        };
        let end = states.len() - 1;
        let same = (1e-3 * extent).max(rounding(&state, omega));
        let repeats = |count: usize| apart(end, count).is_some_and(|apart| apart <= same);
        // A slowly decaying disturbance repeats itself, too, if its frequency is a fraction of that of
        // the drive.
        let dies_out = |count: usize| {
            let around = |quarter: usize| {
                let last = end * quarter / 4;
                let differences =
                    (last.saturating_sub(WINDOW)..=last).filter_map(|index| apart(index, count));
                differences.fold(0.0_f64, f64::max)
            };
            let sizes = [1, 2, 3, 4].map(around);
            end > 8 * WINDOW && sizes.windows(2).all(|pair| pair[1] < FALLING * pair[0])
        };
        Some(Settled {
            state,
            returns_after: (1..=LONGEST).find(|count| repeats(*count) || dies_out(*count)),
            positions,
            peak,
            nearest_returns: nearest_returns(&states, omega, extent),
        })
    }
}

/// The places half-way between two consecutive states, of those after the first half of a simulation, that come
/// nearest to each other; each apart from the others in parts of this size.
///
/// A motion of two periods has that of one period, from which it doubled, between its states, and near
/// each near return of chaos there is a periodic motion (Auerbach and others, Phys. Rev. Lett. 58, 1987, 2387).
fn nearest_returns(states: &[[f64; 2]], omega: f64, size: f64) -> Vec<[f64; 2]> {
    const MOST: usize = 3;
    const APART: f64 = 0.1;
    let distance =
        |one: &[f64; 2], other: &[f64; 2]| (one[0] - other[0]).hypot((one[1] - other[1]) / omega);
    let mut pairs: Vec<&[[f64; 2]]> = states[states.len() / 2..].windows(2).collect();
    pairs.sort_by(|one, other| {
        distance(&one[0], &one[1]).total_cmp(&distance(&other[0], &other[1]))
    });
    let mut places: Vec<[f64; 2]> = Vec::new();
    for pair in pairs {
        let place = [0, 1].map(|index| 0.5 * (pair[0][index] + pair[1][index]));
        if places.iter().all(|other| distance(other, &place) > APART * size) {
            places.push(place);
        }
        if places.len() == MOST {
            break;
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::{PreparedRequest, ResponseRequest};

    /// A pendulum that has turned over comes to rest a turn away, where positions have fewer digits after the
    /// point: it repeats itself after one period.
    #[test]
    fn rest_a_turn_away_repeats_itself() {
        let equation = "x'' + x'/5 + (1 + w*cos(2*t))*sin(x) = 0";
        let question = ResponseRequest::new(equation, "w", [0.1, 0.2], "").expect("a request");
        let asked = PreparedRequest::new(&question, question.equations.oscillator().expect("one"))
            .expect("a request");
        let turns = 6.0 * std::f64::consts::PI;
        let start =
            SettlingStart { start: [turns + 0.3, 0.0], parameter: 0.1, most: 250, known: vec![] };
        let settled = settle_together(&asked.driven, &[start], 1e-4, &mut asked.budget());
        let settled = settled.into_iter().next().flatten().expect("a motion");
        assert_eq!(settled.returns_after, Some(1));
        assert!((settled.state[0] - turns).abs() < 1e-12 && settled.peak < 1e-12);
    }
}

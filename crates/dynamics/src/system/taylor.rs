//! Integration by Taylor series of the states, step by step, for one motion or for several side by
//! side.
//!
//! ```text
//! step: as long as the tolerance allows, to the first corner, critical time or stopping event on it
//! a step whose rates at its end are not those of its series is taken back and halved
//! ```
//!
//! The series are those of [`expansion`](super::expansion), the length of a step that of
//! [`step_length`](super::step_length). Time is measured from the start, so that a late start costs
//! no digits.

use super::expansion::{Expansions, SystemSeries, expressions};
use super::polynomial::value;
use super::roots::{Equations, Root};
use super::steps::{ExpansionPoint, TaylorSteps};
use super::{
    Event, EventCrossing, Path, PathEnd, PathRepresentation, Solver, System, SystemError,
    SystemOptions, end_of_range, is_vanishing, within_range, without_value,
};
use crate::series::tape::{SeriesSums, Tape};

/// Returns the length of the first step by series, and the largest absolute value of every state on
/// it, up to the end of the run or the next corner; `None` if there is no series.
pub(super) fn first_step(
    system: &System,
    [start, end]: [f64; 2],
    values: &[f64],
    events: &[Event],
) -> Option<(f64, Vec<f64>)> {
    const SAMPLES: u32 = 8;
    /// Scales need fewer terms than steps.
    const ORDER: usize = 21;
    let equations = Equations::as_written(system, &expressions(events));
    let mut expansion =
        SystemSeries::to_order(ORDER, &equations, &system.numbers, f64::EPSILON).ok()?;
    expansion.begin(start, values);
    expansion.expand(start, values).ok()?;
    let reach = expansion.longest_step;
    // The series of a free flight reaches to infinity, but the flight ends at the next corner.
    let longest = reach.min(end - start);
    let corner = expansion.first_corner(longest).filter(|(_, place)| *place > 0.0);
    let looked_at = corner.map_or(longest, |(_, place)| place);
    let size = |state: usize| {
        let place = |sample: u32| looked_at * f64::from(sample) / f64::from(SAMPLES);
        let sizes = (0..=SAMPLES).map(|sample| value(expansion.state(state), place(sample)).abs());
        sizes.fold(0.0, f64::max)
    };
    Some((reach, (0..values.len()).map(size).collect()))
}

/// Number of motions side by side: they fill a register of 512 bits, or two or four smaller ones.
pub const LANES: usize = 8;

/// Follows a run to its end.
pub(super) fn follow(mut run: TaylorRun) -> Result<Path, SystemError> {
    loop {
        if let Some(reason) = run.before_step() {
            return Ok(run.finish(reason).0);
        }
        run.memory.expansion.compute();
        let end = match run.prepare()? {
            Prepared::Step(step) => {
                run.sum_alone(step.length);
                run.advance(&step)
            }
            Prepared::TakenBack => None,
            Prepared::Ended(reason) => Some(reason),
        };
        if let Some(reason) = end {
            return Ok(run.finish(reason).0);
        }
    }
}

/// Recurrences for several motions side by side.
struct Lanes {
    series: SystemSeries,
    tape: Tape<LANES>,
    /// The run whose numbers each lane has.
    holders: [Option<usize>; LANES],
    sums: Vec<SeriesSums<LANES>>,
}

impl Lanes {
    fn new(series: &SystemSeries) -> Self {
        Self {
            series: series.clone(),
            tape: series.tape.side_by_side(),
            holders: [None; LANES],
            sums: vec![],
        }
    }

    /// Computes the series of these runs, each about its own point.
    fn expand(&mut self, lanes: &[usize], runs: &mut [TaylorRun]) {
        for (lane, index) in lanes.iter().enumerate() {
            let own = &runs[*index].memory.expansion.tape;
            match self.holders[lane] == Some(*index) {
                true => self.tape.load_point(lane, self.series.variables(), own),
                false => self.tape.load(lane, own),
            }
            self.holders[lane] = Some(*index);
        }
        self.tape.expand(self.series.rates());
        let bounds = self.series.bounds(&self.tape);
        for (lane, index) in lanes.iter().enumerate() {
            runs[*index].memory.expansion.take_from(&self.tape, lane, &bounds);
        }
    }

    /// Takes one step of each of these runs, or takes its last one back; an entry of `ends` is the
    /// end of a run that ends there.
    fn step(
        &mut self,
        lanes: &[usize],
        runs: &mut [TaylorRun],
        ends: &mut [Option<Result<PathEnd, SystemError>>],
    ) {
        self.expand(lanes, runs);
        let mut lengths = [0.0; LANES];
        let mut steps = [const { None }; LANES];
        let mut variables = 0;
        for (lane, index) in lanes.iter().enumerate() {
            let run = &mut runs[*index];
            match run.prepare() {
                Ok(Prepared::Step(step)) => {
                    variables = run.memory.values.len();
                    lengths[lane] = step.length;
                    steps[lane] = Some(step);
                }
                Ok(Prepared::TakenBack) => {}
                Ok(Prepared::Ended(reason)) => ends[*index] = Some(Ok(reason)),
                Err(error) => ends[*index] = Some(Err(error)),
            }
        }
        self.sums.resize(variables, SeriesSums::default());
        self.tape.sums(&lengths, &mut self.sums);
        for (lane, (index, step)) in lanes.iter().zip(&steps).enumerate() {
            let (run, Some(step)) = (&mut runs[*index], step) else { continue };
            match run.memory.expansion.is_of_lane() {
                true => run.sum_from(lane, &self.sums),
                false => run.sum_alone(step.length),
            }
            ends[*index] = run.advance(step).map(Ok);
        }
    }
}

/// Follows several runs, up to [`LANES`] of those with the same recurrences side by side, and
/// returns their paths in order, with the memory of each; each path is bit for bit the same as alone.
fn follow_together<'a>(
    mut runs: Vec<TaylorRun<'a>>,
    tapes: &mut Vec<Lanes>,
) -> impl Iterator<Item = Result<(Path, Box<RunMemory>), SystemError>> + use<'a> {
    for lanes in tapes.iter_mut() {
        lanes.holders = [None; LANES];
    }
    let mut ends: Vec<Option<Result<PathEnd, SystemError>>> = runs.iter().map(|_| None).collect();
    while let Some(first) = ends.iter().position(Option::is_none) {
        let alike = |index: &usize| {
            ends[*index].is_none()
                && runs[*index].memory.expansion.is_like(&runs[first].memory.expansion)
        };
        let (mut lanes, mut count) = ([0; LANES], 0);
        for index in (first..runs.len()).filter(alike).take(LANES) {
            lanes[count] = index;
            count += 1;
        }
        let mut going = 0;
        for place in 0..count {
            let index = lanes[place];
            ends[index] = runs[index].before_step().map(Ok);
            if ends[index].is_none() {
                lanes[going] = index;
                going += 1;
            }
        }
        let lanes = &lanes[..going];
        let Some(series) = lanes.first().map(|index| &runs[*index].memory.expansion) else {
            continue;
        };
        let known = tapes.iter().position(|own| own.series.is_like(series));
        let known = known.unwrap_or_else(|| {
            tapes.push(Lanes::new(series));
            tapes.len() - 1
        });
        tapes[known].step(lanes, &mut runs, &mut ends);
    }
    let finished =
        |(run, end): (TaylorRun, Result<PathEnd, SystemError>)| end.map(|end| run.finish(end));
    runs.into_iter().zip(ends.into_iter().flatten()).map(finished)
}

/// The memory of runs that have ended, boxed: a run that is moved leaves it where it is.
type IdleMemory = Vec<Box<RunMemory>>;

/// Integrates several motions side by side, round after round, and keeps the memory of a round for the next
/// one: a motion from event to event needs a path for each of its flights.
#[derive(Default)]
pub struct SideBySide {
    tapes: Vec<Lanes>,
    idle: IdleMemory,
}

impl SideBySide {
    /// Integrates several motions as [`solve_together`](super::solve_together) does, to the same bits.
    pub fn solve(
        &mut self,
        motions: &[(&Solver, [f64; 2], &[f64])],
    ) -> Vec<Result<Path, SystemError>> {
        let Self { tapes, idle } = self;
        let mut runs: Vec<TaylorRun> = Vec::with_capacity(motions.len());
        let mut paths: Vec<Option<Result<Path, SystemError>>> = Vec::with_capacity(motions.len());
        for &(solver, times, values) in motions {
            let Solver { system, events, options, expansions, .. } = solver;
            let run = match expansions {
                Some(Ok(own)) if system.check(times, values, options).is_ok() => {
                    TaylorRun::new(system, times, values, events, options, own, idle).ok()
                }
                _ => None,
            };
            paths.push(run.is_none().then(|| solver.solve(times, values)));
            runs.extend(run);
        }
        let mut together = follow_together(runs, tapes);
        for path in paths.iter_mut().filter(|path| path.is_none()) {
            *path = together.next().map(|followed| {
                followed.map(|(path, memory)| {
                    idle.push(memory);
                    path
                })
            });
        }
        paths.into_iter().flatten().collect()
    }
}

/// The state of a run and its recurrences, and the memory for them, in which another run of the same equations
/// may begin.
pub(super) struct RunMemory {
    /// The signs of the arguments of the roots.
    root_signs: Vec<f64>,
    /// All recurrences of the equations.
    expansions: Expansions,
    /// The recurrences for these signs.
    expansion: SystemSeries,
    /// The recurrences for other signs, which the motion has left.
    left: Vec<(Vec<f64>, SystemSeries)>,
    /// The states, then the variables of the roots that act.
    values: Vec<f64>,
    /// The signs of the event functions after the last step.
    signs: Vec<f64>,
    /// The crossings of events on the last step.
    met: Vec<(usize, f64, bool)>,
    /// The sums of the series of the states and of the variables of the roots at the end of the next
    /// step.
    at_end: Vec<SeriesSums>,
    /// The data to take back the last step.
    last: StepUndo,
}

impl RunMemory {
    /// Takes idle memory of a run of these equations on the same side of their roots, or new one.
    ///
    /// # Errors
    /// There are no series on this side.
    fn take(
        idle: &mut IdleMemory,
        (system, events): (&System, &[Event]),
        expansions: &Expansions,
        signs: &[f64],
    ) -> Result<Box<Self>, SystemError> {
        let fits = |own: &Self| own.root_signs == signs && own.expansions.is_like(expansions);
        if let Some(found) = idle.iter().rposition(|own| fits(own)) {
            let mut memory = idle.swap_remove(found);
            if memory.expansion.begin_anew(&system.numbers) {
                memory.left.clear();
                return Ok(memory);
            }
        }
        let no_series = || SystemError::Start(system.state.first().copied().unwrap_or(system.time));
        Ok(Box::new(Self {
            expansion: expansions.on_side(system, events, signs).ok_or_else(no_series)?,
            root_signs: signs.to_vec(),
            expansions: expansions.clone(),
            left: vec![],
            values: vec![],
            signs: vec![],
            met: vec![],
            at_end: vec![],
            last: StepUndo::default(),
        }))
    }

    /// Sets the states, and with them the variables of the roots that act.
    fn set(&mut self, system: &System, start: f64, states: &[f64]) {
        let acting = self.expansion.acting.iter().map(|root| &self.expansions.roots[*root]);
        self.values.clear();
        self.values.extend_from_slice(states);
        self.values.extend(acting.map(|root| root.variable_at(system, start, states)));
    }
}

/// A run in progress.
pub(super) struct TaylorRun<'a> {
    system: &'a System,
    events: &'a [Event],
    options: &'a SystemOptions,
    expansions: &'a Expansions,
    memory: Box<RunMemory>,
    start: f64,
    end: f64,
    duration: f64,
    /// The time since the start.
    time: f64,
    steps: TaylorSteps,
    /// Number of consecutive steps that returned to a corner at once.
    stuck: usize,
    /// The corner at which the last step ended, and the speed of its argument there.
    met: Option<(usize, f64)>,
    /// Whether the last step may be taken back: not if it ended at a corner or an event.
    is_open: bool,
    /// Number of halvings of the step from the present point.
    halvings: i32,
}

/// Largest number of consecutive halvings of a step.
const MOST_HALVINGS: i32 = 12;

/// The result of the look at a point of expansion.
enum Prepared {
    Step(NextStep),
    /// The last step was taken back.
    TakenBack,
    /// The run ends here.
    Ended(PathEnd),
}

/// A step that is about to be taken.
struct NextStep {
    /// The value of the variable of the series at its end if there is no corner.
    reach: f64,
    /// The value of the variable at its end.
    length: f64,
    /// The time since the start at which it ends.
    until: f64,
    /// The first corner on it, and the value of the variable there.
    corner: Option<(usize, f64)>,
}

/// The values that are restored if a step is taken back.
#[derive(Default)]
struct StepUndo {
    length: f64,
    values: Vec<f64>,
    signs: Vec<f64>,
    sides: Vec<f64>,
    occurrences: usize,
    /// The change of each state at its rate at the end of the step, and the size of its terms
    /// there.
    changes: Vec<[f64; 2]>,
}

impl<'a> TaylorRun<'a> {
    /// Prepares a run between two times from these values, in the memory of one that has ended if one of
    /// those that are idle fits.
    ///
    /// # Errors
    /// [`SystemError`] if there is no series on any side of the roots.
    pub(super) fn new(
        system: &'a System,
        [start, end]: [f64; 2],
        from: &[f64],
        events: &'a [Event],
        options: &'a SystemOptions,
        expansions: &'a Expansions,
        idle: &mut IdleMemory,
    ) -> Result<Self, SystemError> {
        let no_series = || SystemError::Start(system.state.first().copied().unwrap_or(system.time));
        let sign = |root: &Root| match root.argument_at(system, start, from) < 0.0 {
            true => -1.0,
            false => 1.0,
        };
        let mut root_signs: Vec<f64> = expansions.roots.iter().map(sign).collect();
        let mut memory = RunMemory::take(idle, (system, events), expansions, &root_signs)?;
        memory.set(system, start, from);
        // A motion that begins where a root does may begin towards either side.
        for attempt in 0..=root_signs.len() {
            let RunMemory { expansion, values, .. } = memory.as_mut();
            expansion.begin(start, values);
            let left = expansion.left_root(&root_signs).filter(|_| attempt < root_signs.len());
            let Some(left) = left else { break };
            root_signs[left] *= -1.0;
            *expansion = expansions.on_side(system, events, &root_signs).ok_or_else(no_series)?;
            memory.set(system, start, from);
        }
        memory.expansion.take_root_sides(&root_signs);
        memory.root_signs = root_signs;
        memory.signs.clear();
        memory.signs.resize(events.len(), 0.0);
        let steps = TaylorSteps::new(from.len(), expansions.order(), &expansions.memory);
        Ok(Self {
            system,
            events,
            options,
            expansions,
            memory,
            start,
            end,
            duration: end - start,
            time: 0.0,
            steps,
            stuck: 0,
            met: None,
            is_open: false,
            halvings: 0,
        })
    }

    /// Returns the path of a run that has ended, and its memory.
    fn finish(mut self, reason: PathEnd) -> (Path, Box<RunMemory>) {
        let states = &self.memory.values[..self.system.state.len()];
        if self.steps.count() == 0 {
            // A run that ended at its start gets one step of length zero.
            self.steps = TaylorSteps::at_rest(states);
        } else {
            self.steps.lists.last.extend_from_slice(states);
        }
        let on_side = |signs: &[f64]| self.expansions.on_side(self.system, self.events, signs);
        self.steps.finish(self.start, self.memory.root_signs.len(), on_side);
        let path = Path {
            end: if reason == PathEnd::Reached { self.end } else { self.start + self.time },
            motion: PathRepresentation::Taylor { steps: self.steps, start: self.start },
            reason,
        };
        (path, self.memory)
    }

    /// Sets the expansion at the start of the next step; returns the reason if the run ends there.
    fn before_step(&mut self) -> Option<PathEnd> {
        let over = self.time >= self.duration;
        if !over && self.steps.count() >= self.options.step_limit {
            return Some(PathEnd::StepLimit);
        }
        if !over && self.options.interrupt.is_requested() {
            return Some(PathEnd::Interrupted);
        }
        self.memory.expansion.expand_about(self.start + self.time, &self.memory.values);
        None
    }

    /// Looks at the computed series: takes the last step back if it went astray, and measures the
    /// next one.
    ///
    /// # Errors
    /// [`SystemError`] for a state or an event without a value at the start of the run.
    fn prepare(&mut self) -> Result<Prepared, SystemError> {
        let over = self.time >= self.duration;
        let now = self.start + self.time;
        let defined = self.defined();
        if std::mem::take(&mut self.is_open) {
            if self.halvings < MOST_HALVINGS && (defined.is_err() || self.has_missed_something(now))
            {
                self.take_back();
                return Ok(Prepared::TakenBack);
            }
            self.halvings = 0;
        }
        match defined {
            Err(_) if over => return Ok(Prepared::Ended(PathEnd::Reached)),
            Err(error) if self.steps.count() == 0 => return Err(error),
            Err(_) => return Ok(Prepared::Ended(self.without_value())),
            Ok(()) => {}
        }
        if over {
            return Ok(Prepared::Ended(PathEnd::Reached));
        }
        let Some(step) = self.next_step(now) else {
            return Ok(Prepared::Ended(PathEnd::Singular));
        };
        let reach = step.reach;
        let met = self.met.take();
        if met.is_some_and(|(corner, speed)| {
            self.memory.expansion.stays_on(corner, speed * reach, reach)
        }) {
            return Ok(Prepared::Ended(PathEnd::Sticks));
        }
        Ok(Prepared::Step(step))
    }

    /// Sums the series at the end of the next step on the tape of this run.
    fn sum_alone(&mut self, length: f64) {
        self.memory.at_end.resize(self.memory.values.len(), SeriesSums::default());
        self.memory.expansion.tape.sums(&[length], &mut self.memory.at_end);
    }

    /// Takes the sums of a lane at the end of the next step.
    fn sum_from<const L: usize>(&mut self, lane: usize, sums: &[SeriesSums<L>]) {
        self.memory.at_end.clear();
        self.memory.at_end.extend(sums.iter().map(|sums| sums.of_lane(lane)));
    }

    /// Checks that all states and events have a series here.
    ///
    /// # Errors
    /// [`SystemError`] with the first state or event without one.
    fn defined(&mut self) -> Result<(), SystemError> {
        let settled = self.memory.expansion.switch_corners();
        // Behind the states come the variables of the roots.
        let name = |state: usize| *self.system.state.get(state).unwrap_or(&self.system.time);
        settled.map_err(|state| SystemError::Start(name(state)))?;
        match self.memory.expansion.undefined_event() {
            Some(event) => Err(SystemError::Event(event)),
            None => Ok(()),
        }
    }

    /// Returns the reason why the run ends here if there is no series.
    fn without_value(&self) -> PathEnd {
        let before = self.steps.last_start().unwrap_or(self.time);
        without_value(self.memory.values.iter().copied(), [before, self.time])
    }

    /// Returns the next step: the longest within the tolerance, shortened so that it crosses neither
    /// the end of the run, nor a critical time, nor a narrow place. `None` if it has no length.
    fn next_step(&mut self, now: f64) -> Option<NextStep> {
        let left = self.duration - self.time;
        let next = next_critical(&self.system.critical, now);
        let limit = next.map_or(left, |next| (next - now).min(left));
        let longest = match self.memory.expansion.acting.is_empty() {
            true => self.memory.expansion.longest_step.min(limit),
            // At rest in contact the series are constant, and the time is proportional to s.
            false => self
                .memory
                .expansion
                .longest_step
                .min(2.0 * limit / self.memory.expansion.time_rate()),
        };
        let corner = self.memory.expansion.first_corner(longest);
        // Beyond the end of contact the time would go back.
        let forward = corner.map_or(longest, |(_, place)| place);
        let within = self.memory.expansion.step_within(limit, forward);
        let longest = within.unwrap_or(longest);
        let reach = self.memory.expansion.short_of_narrow(longest) * 0.5_f64.powi(self.halvings);
        let corner = corner.filter(|(_, place)| *place <= reach);
        let until = match within.is_some() && reach == longest && limit == left {
            true => self.duration,
            false => self.time + self.memory.expansion.elapsed(reach),
        };
        // Where a root acts, its variable moves on although the time may not.
        let moves = match self.memory.expansion.acting.is_empty() {
            true => now + reach > now,
            false => corner.is_some() || self.memory.expansion.elapsed(reach) > 0.0,
        };
        let length = corner.map_or(reach, |(_, place)| place);
        (reach > 0.0 && moves).then_some(NextStep { reach, length, until, corner })
    }

    /// Advances to the end of a step, at which the series have been summed, or to the first stopping
    /// event on it. Returns the reason if the run ends there.
    fn advance(&mut self, step: &NextStep) -> Option<PathEnd> {
        let &NextStep { reach, mut length, until, mut corner } = step;
        self.remember(length);
        let range = match within_range(self.memory.values.iter().copied()) {
            true => None,
            false => end_of_range(length, |place| {
                self.memory.expansion.tape.values(place, &mut self.memory.values);
                within_range(self.memory.values.iter().copied())
            }),
        };
        if let Some(end) = range {
            (corner, length) = (None, end);
        }
        let mut met = std::mem::take(&mut self.memory.met);
        self.memory.expansion.crossings(&mut self.memory.signs, length, &mut met);
        met.retain(|(event, _, rising)| self.events[*event].counts(*rising));
        let stop = met.iter().position(|found| self.events[found.0].stops);
        let stop = stop.map(|index| {
            met.truncate(index + 1);
            length = met[index].1;
            met[index].0
        });
        let (start, time) = (self.start, self.time);
        let crossings = met.iter().map(|(event, place, rising)| EventCrossing {
            event: *event,
            time: start + (time + self.memory.expansion.elapsed(*place)),
            rising: *rising,
        });
        self.steps.lists.occurrences.extend(crossings);
        self.memory.met = met;
        let series = (0..self.system.state.len()).map(|state| self.memory.expansion.state(state));
        let point = ExpansionPoint {
            root_signs: &self.memory.root_signs,
            sides: &self.memory.last.sides,
            values: &self.memory.last.values,
        };
        self.steps.push([time, length], &point, series, self.memory.expansion.time());
        self.steps.forget_before(self.options.keep_from - start);
        if stop.is_some() || range.is_some() {
            self.memory.expansion.tape.values(length, &mut self.memory.values);
        }
        let whole = corner.is_none() && stop.is_none() && range.is_none();
        self.is_open = whole;
        self.time = if whole { until } else { time + self.memory.expansion.elapsed(length) };
        if let Some(event) = stop {
            return Some(PathEnd::Event(event));
        }
        if range.is_some() {
            return Some(match is_vanishing([time, self.time]) {
                true => PathEnd::Singular,
                false => PathEnd::Overflow,
            });
        }
        let (corner, _) = corner?;
        self.halvings = 0;
        // A motion that leaves a corner and returns at once, over and over, sticks to it.
        const OFTEN: usize = 20;
        let [gone, whole] = [length, reach].map(|place| self.memory.expansion.elapsed(place));
        let at_once = gone <= 1e-12 * whole + 4.0 * f64::EPSILON * self.time;
        self.stuck = if at_once { self.stuck + 1 } else { 0 };
        if self.stuck > OFTEN {
            return Some(PathEnd::Sticks);
        }
        if corner < self.memory.root_signs.len() {
            return self.pass_root(corner);
        }
        self.met = self.memory.expansion.speed_at(corner, length).map(|speed| (corner, speed));
        self.memory.expansion.cross(corner);
        None
    }

    /// Takes the states at the end of a step, and keeps those before it.
    fn remember(&mut self, length: f64) {
        let last = &mut self.memory.last;
        (last.length, last.occurrences) = (length, self.steps.lists.occurrences.len());
        std::mem::swap(&mut last.values, &mut self.memory.values);
        self.memory.values.clear();
        self.memory.values.extend(self.memory.at_end.iter().map(|sums| sums.value[0]));
        last.signs.clone_from(&self.memory.signs);
        last.sides.clear();
        last.sides.extend(self.memory.expansion.tape.corners().map(|(_, side)| side));
        let states = self.memory.at_end.iter().take(self.system.state.len());
        last.changes.clear();
        last.changes.extend(states.map(|sums| [sums.change[0], sums.size[0]]));
    }

    /// Goes over to the other side of a root. Returns the reason if the run ends there.
    fn pass_root(&mut self, passed: usize) -> Option<PathEnd> {
        let before = self.memory.root_signs.clone();
        self.memory.root_signs[passed] *= -1.0;
        let known = self.memory.left.iter().position(|(signs, _)| *signs == self.memory.root_signs);
        let next = match known {
            Some(known) => Some(self.memory.left.swap_remove(known).1),
            None => self.expansions.on_side(self.system, self.events, &self.memory.root_signs),
        };
        let Some(mut next) = next else { return Some(PathEnd::Singular) };
        let (states, variables) = self.memory.values.split_at(self.system.state.len());
        let now = self.start + self.time;
        let variable = |root: &usize| {
            let before = self.memory.expansion.acting.iter().position(|own| own == root);
            match before {
                _ if *root == passed => 0.0,
                Some(place) => variables[place],
                None => self.expansions.roots[*root].variable_at(self.system, now, states),
            }
        };
        let variables = next.acting.iter().map(variable);
        let values: Vec<f64> = states.iter().copied().chain(variables).collect();
        if next.tape.corners().count() > next.roots {
            next.begin(now, &values);
        }
        next.take_root_sides(&self.memory.root_signs);
        self.memory.values = values;
        self.memory.left.push((before, std::mem::replace(&mut self.memory.expansion, next)));
        None
    }

    /// Whether the rates at the end of a step differ from those of its series, for instance because
    /// of a wall that did not show at its beginning.
    fn has_missed_something(&mut self, now: f64) -> bool {
        /// Largest error of a rate times the step, over the size of the state on it.
        const ASTRAY: f64 = 1e-8;
        // The truncated terms are within the tolerance, and their derivatives within the tolerance
        // times the next order.
        let astray = ASTRAY.max((self.memory.expansion.order + 1) as f64 * self.options.tolerance);
        let length = self.memory.last.length;
        let apart = |(state, [change, size]): (usize, &[f64; 2])| {
            let apart = (change - self.memory.expansion.rate(state) * length).abs();
            (apart > astray * size).then_some((state, apart / length))
        };
        let missed: Vec<(usize, f64)> =
            self.memory.last.changes.iter().enumerate().filter_map(apart).collect();
        !missed.is_empty() && !self.is_rounding(&missed, now)
    }

    /// Whether the errors of these rates, each given with the index of its state, are no larger
    /// than the last digits of the states can cause. Two bodies that touch to within rounding push
    /// each other by the rounding of their positions, which may be the only force on a step from
    /// rest.
    fn is_rounding(&mut self, missed: &[(usize, f64)], now: f64) -> bool {
        /// Number of units in the last place of a state that count as rounding.
        const DIGITS: f64 = 4.0;
        let here: Vec<f64> =
            missed.iter().map(|(state, _)| self.memory.expansion.rate(*state)).collect();
        let mut by_rounding = vec![0.0; missed.len()];
        let mut values = self.memory.values.clone();
        for state in 0..self.system.state.len() {
            values[state] += DIGITS * f64::EPSILON * self.memory.values[state].abs();
            let expanded = values[state] != self.memory.values[state]
                && self.memory.expansion.expand_once(now, &values);
            if expanded {
                for ((sum, here), (missed, _)) in by_rounding.iter_mut().zip(&here).zip(missed) {
                    *sum += (self.memory.expansion.rate(*missed) - here).abs();
                }
            }
            values[state] = self.memory.values[state];
        }
        // The expansion at the unchanged state is restored.
        let again = self.memory.expansion.expand_once(now, &self.memory.values);
        again && missed.iter().zip(by_rounding).all(|((_, apart), sum)| *apart <= sum)
    }

    /// Returns to the start of the last step, from which half of it will be taken.
    fn take_back(&mut self) {
        let Some(time) = self.steps.pop() else { return };
        let last = &self.memory.last;
        self.time = time;
        self.memory.values.clone_from(&last.values);
        self.memory.signs.clone_from(&last.signs);
        self.memory.expansion.set_sides(&last.sides);
        self.steps.lists.occurrences.truncate(last.occurrences);
        self.halvings += 1;
    }
}

/// Returns the next of these times that is farther away than rounding; `None` if there is none.
fn next_critical(critical: &[f64], now: f64) -> Option<f64> {
    let beyond = now + 4.0 * f64::EPSILON * now.abs();
    critical.get(critical.partition_point(|time| *time <= beyond)).copied()
}

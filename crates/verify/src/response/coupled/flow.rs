//! The motion of first-order equations over a time, with its derivatives by the start and by a
//! parameter, by a Runge-Kutta method.
//!
//! ```text
//! y' = F(t, y; p),   Z' = F_y Z,   z' = F_y z + F_p         Z(0) = 1,  z(0) = 0
//! ```
//!
//! States and variations are counted in the sizes of the states, so that one tolerance suits all.
//! Where the right sides jump, the motion is followed from event to event by `sliding`.
//!
//! In: the right sides as expressions. Out: the state after a time, its derivatives, and between
//! which values each state was on the way. A step costs 16 evaluations of the right sides and of
//! those derivatives that are not zero, s of them, and 16 s n products for the variations.

use std::cell::{Cell, RefCell};

use nalgebra::{DMatrix, DVector};

use super::scaled_rates::ScaledRates;
use super::sliding::{self, SlidingRun, SlidingStop};
use super::surfaces::{FlowEvent, JumpSurfaces, Table};
use crate::expr::Expr;
use crate::interrupt::Interrupt;
use crate::numeric::ode::{IntegrationOptions, Point, end_or_event};
use crate::response::ResponseError;
use crate::symbol::Symbol;

/// Relative error of a step, in the sizes of the states.
pub(super) const TOLERANCE: f64 = 1e-12;

/// Unit of the variations beside the states: their relative error may be this much larger, since they
/// are steps of Newton's method and multipliers, and not the motion.
const UNIT_OF_VARIATIONS: f64 = 1e-4;

/// Largest number of steps over one period.
const STEPS: usize = 20_000;

/// The right sides of first-order equations, compiled with their derivatives.
#[derive(Clone, Debug)]
pub(super) struct Flow {
    /// The number of states.
    pub(super) states: usize,
    /// Whether no corner occurs, such as `abs` or `max`.
    smooth: bool,
    /// f.
    rates: Table,
    /// f, f_y, f_p, a row for each state.
    varied: Table,
    /// The surfaces across which the right sides jump.
    jumps: Option<JumpSurfaces>,
    /// The request to stop, after which no motion is followed to its end.
    interrupt: Interrupt,
    /// The reason why the last motion that was not followed across jumps was not.
    stopped: Cell<Option<SlidingStop>>,
    /// The reason why a motion ended at an event, if one did.
    ended: Cell<Option<SlidingStop>>,
    /// The step with which the last motion without variations would have gone on: the next one, which begins
    /// where that ended or near it, is tried with it. Zero where nothing is known: the rates choose one then.
    next_step: Cell<f64>,
    /// The rates of the last motion without variations, with its parameter.
    prepared: RefCell<Option<(f64, ScaledRates)>>,
    /// The evaluations of the right sides so far, each counted as often as there are motions and variations.
    evaluations: Cell<u64>,
}

/// The right sides and their derivatives at a state.
#[derive(Clone, Debug)]
pub(super) struct LinearisedRates {
    /// The rates F.
    pub(super) rates: DVector<f64>,
    /// F_y.
    pub(super) by_state: DMatrix<f64>,
    /// F_p.
    pub(super) by_parameter: DVector<f64>,
}

/// A motion over a time.
#[derive(Clone, Debug)]
pub(super) struct FlowImage {
    /// The state at the end.
    pub(super) end: DVector<f64>,
    /// Its derivative by the start.
    pub(super) by_start: DMatrix<f64>,
    /// Its derivative by the parameter.
    pub(super) by_parameter: DVector<f64>,
    /// Half of the way of each state from its lowest to its highest value.
    pub(super) travel: Vec<f64>,
    /// Rests, impacts and events on the way.
    pub(super) encounters: Encounters,
}

/// Rests, impacts and events of a motion over a time.
#[derive(Clone, Debug)]
pub(super) struct Encounters {
    /// The part of the time in which dry friction holds something, or something rests on a wall.
    pub(super) stuck: f64,
    /// The number of impacts on walls, without those that accumulate before a rest.
    pub(super) impacts: usize,
    /// The number of rests on walls that begin.
    pub(super) rests: usize,
    /// The number of other events.
    pub(super) events: usize,
    /// The least speed at which a wall is hit or an event begins, in the sizes of the states over the time;
    /// infinite if there is none.
    pub(super) slowest: f64,
    /// The factors c of the states of sums c y that stay what they are because dry friction holds them all
    /// the time, independent of each other: of such a motion there is one for each place where it holds them.
    pub(super) places: Vec<Vec<f64>>,
    /// The times of impacts and other events.
    pub(super) times: Vec<f64>,
}

impl Encounters {
    /// No rest, no impact and no event.
    const NONE: Self = Self {
        stuck: 0.0,
        impacts: 0,
        rests: 0,
        events: 0,
        slowest: f64::INFINITY,
        places: vec![],
        times: vec![],
    };

    /// The numbers of impacts, of rests on walls and of other events.
    pub(super) fn counts(&self) -> [usize; 3] {
        [self.impacts, self.rests, self.events]
    }
}

impl Flow {
    /// Compiles the right sides and the events in the states, the time and the parameter.
    ///
    /// # Errors
    /// [`ResponseError`] for a derivative that cannot be written, or another name.
    pub(super) fn new(
        states: &[Symbol],
        time: Symbol,
        right: &[Expr],
        parameter: Symbol,
        events: &[FlowEvent],
    ) -> Result<Self, ResponseError> {
        let arguments: Vec<Symbol> = states.iter().copied().chain([time, parameter]).collect();
        let row = |rate: &Expr| -> Result<Vec<Expr>, ResponseError> {
            let slope = |name: &Symbol| match rate.contains(*name) {
                true => rate.differentiate(*name),
                false => Ok(Expr::zero()),
            };
            let mut row = vec![rate.clone()];
            for name in states.iter().chain([&parameter]) {
                row.push(slope(name)?);
            }
            Ok(row)
        };
        let varied: Vec<Vec<Expr>> = right.iter().map(row).collect::<Result<_, _>>()?;
        let rates: Vec<Vec<Expr>> = right.iter().map(|rate| vec![rate.clone()]).collect();
        Ok(Self {
            states: states.len(),
            smooth: !right.iter().any(Expr::contains_corner),
            rates: Table::new(&rates, &arguments)?,
            varied: Table::new(&varied, &arguments)?,
            jumps: JumpSurfaces::new(states, time, right, parameter, events)?,
            interrupt: Interrupt::default(),
            stopped: Cell::new(None),
            ended: Cell::new(None),
            next_step: Cell::new(0.0),
            prepared: RefCell::new(None),
            evaluations: Cell::new(0),
        })
    }

    /// This flow with an interrupt: no motion is followed to its end once that is requested.
    pub(super) fn until(self, interrupt: Interrupt) -> Self {
        Self { interrupt, ..self }
    }

    /// Whether the right sides jump, or the states at an event.
    pub(super) fn jumps(&self) -> bool {
        self.jumps.is_some()
    }

    /// The state mirrored in every wall behind which it is, so that a motion can begin there.
    pub(super) fn in_front_of_walls(&self, state: Vec<f64>, parameter: f64) -> Vec<f64> {
        match &self.jumps {
            Some(jumps) => sliding::in_front_of_walls(jumps, state, parameter),
            None => state,
        }
    }

    /// Whether a state is on a surface across which the right sides jump, at time zero.
    pub(super) fn is_on_jump(&self, state: &[f64], parameter: f64) -> bool {
        let jumps = self.jumps.as_ref();
        jumps.is_some_and(|jumps| sliding::is_on_surface(jumps, state, 0.0, parameter))
    }

    /// Whether nothing jumps where the rate of a coordinate is zero, or that of a velocity at its largest
    /// value.
    pub(super) fn has_smooth_turn(&self, states: &[Symbol], state: usize) -> bool {
        self.jumps.as_ref().is_none_or(|jumps| jumps.has_smooth_turn(states, state))
    }

    /// The reason why the last motion that was not followed across jumps was not, with the argument of
    /// the jump.
    pub(super) fn stopped(&self) -> Option<(SlidingStop, Expr)> {
        let stop = self.stopped.get()?;
        let arguments = &self.jumps.as_ref()?.arguments;
        match stop {
            SlidingStop::Chatter(index) | SlidingStop::Undetermined(index) => {
                Some((stop, arguments.get(index)?.clone()))
            }
            SlidingStop::NoValue | SlidingStop::RestsOnWall(..) | SlidingStop::EventsAccumulate => {
                None
            }
        }
    }

    /// The least gap of an event at a time, where every state changes by a unit of its size; infinite
    /// without events.
    pub(super) fn least_gap(&self, state: &[f64], time: f64, parameter: f64, sizes: &[f64]) -> f64 {
        let least = |jumps| sliding::least_gap(jumps, state, [time, parameter], sizes);
        self.jumps.as_ref().map_or(f64::INFINITY, least)
    }

    /// The state behind the nearest event at a time; `None` without events.
    pub(super) fn behind_event(
        &self,
        state: &[f64],
        time: f64,
        parameter: f64,
    ) -> Option<Vec<f64>> {
        sliding::behind_event(self.jumps.as_ref()?, state, [time, parameter])
    }

    /// The state, at the beginning of a motion of some duration, on the walls from which it is apart by no more
    /// than a search for an orbit leaves.
    pub(super) fn onto_walls(
        &self,
        state: &[f64],
        [time, duration]: [f64; 2],
        parameter: f64,
    ) -> Vec<f64> {
        let Some(jumps) = &self.jumps else { return state.to_vec() };
        let rates = self.rates_at(state, time, parameter);
        let sizes = state.iter().zip(rates.iter());
        let sizes: Vec<f64> =
            sizes.map(|(value, rate)| value.abs() + rate.abs() * duration).collect();
        sliding::onto_walls(jumps, state.to_vec(), &sizes, [time, parameter])
    }

    /// The gaps of all events at a state and a time with a parameter, each with its rate.
    pub(super) fn gaps(&self, state: &[f64], time: f64, parameter: f64) -> Vec<[f64; 2]> {
        let jumps = self.jumps.as_ref();
        jumps.map_or(vec![], |jumps| sliding::gaps(jumps, state, [time, parameter]))
    }

    /// This flow without one of the events within a duration at both ends of each run.
    pub(super) fn without_event_at_ends(mut self, event: usize, duration: f64) -> Self {
        let events = self.jumps.iter_mut().flat_map(|jumps| &mut jumps.events);
        if let Some(event) = { events }.nth(event) {
            event.unwatched = duration;
        }
        self
    }

    /// The times of the impacts and events of a motion between two times; `None` if it cannot be followed.
    pub(super) fn event_times(
        &self,
        start: &[f64],
        times: [f64; 2],
        parameter: f64,
        sizes: &[f64],
    ) -> Option<Vec<f64>> {
        match &self.jumps {
            Some(jumps) => Some(self.sliding(jumps, start, times, parameter, sizes, None)?.times),
            None => Some(vec![]),
        }
    }

    /// The reason why a motion was not followed beyond an event: a rest on a wall, or an accumulation.
    pub(super) fn ended_at_event(&self) -> Option<ResponseError> {
        let events = &self.jumps.as_ref()?.events;
        let gap = |wall: usize| Some(events.get(wall)?.expression.to_string());
        Some(match self.ended.get()? {
            SlidingStop::RestsOnWall(wall, None) => ResponseError::RestsOnWall(gap(wall)?),
            SlidingStop::RestsOnWall(wall, Some(other)) => {
                ResponseError::RestsOnTwoWalls(gap(wall.min(other))?, gap(wall.max(other))?)
            }
            _ => ResponseError::EventsAccumulate,
        })
    }

    /// The motion across jumps between two times; `None` if it cannot be followed.
    fn sliding(
        &self,
        jumps: &JumpSurfaces,
        start: &[f64],
        times: [f64; 2],
        parameter: f64,
        sizes: &[f64],
        unit: Option<f64>,
    ) -> Option<SlidingRun> {
        let mut options = self.options(times[1] - times[0], jumps.smooth);
        if unit.is_none() {
            options.first_step = self.next_step.replace(0.0);
        }
        match sliding::follow(jumps, start, times, parameter, sizes, unit, &options) {
            Ok(run) => {
                if unit.is_none() {
                    self.next_step.set(run.next_step);
                }
                self.evaluations.set(self.evaluations.get() + run.evaluations);
                Some(run)
            }
            Err(stop) => {
                // What was stopped has cost something too: a run of one evaluation a step.
                self.evaluations.set(self.evaluations.get() + STEPS as u64);
                self.stopped.set(Some(stop));
                if matches!(stop, SlidingStop::RestsOnWall(..) | SlidingStop::EventsAccumulate) {
                    self.ended.set(Some(stop));
                }
                None
            }
        }
    }

    /// The rates at a state.
    pub(super) fn rates_at(&self, state: &[f64], time: f64, parameter: f64) -> DVector<f64> {
        let arguments: Vec<f64> = state.iter().copied().chain([time, parameter]).collect();
        let mut rates = DVector::zeros(self.states);
        if let Some(jumps) = &self.jumps {
            let found = sliding::linearised(jumps, state, time, parameter);
            return found.map_or_else(|| rates.add_scalar(f64::NAN), |(rates, _)| rates);
        }
        self.rates.visit(&arguments, |(row, _), rate| rates[row] = rate);
        rates
    }

    /// The rates and their derivatives at a state.
    pub(super) fn linearised(&self, state: &[f64], time: f64, parameter: f64) -> LinearisedRates {
        let arguments: Vec<f64> = state.iter().copied().chain([time, parameter]).collect();
        let n = self.states;
        if let Some(jumps) = &self.jumps {
            let (rates, slopes) = sliding::linearised(jumps, state, time, parameter)
                .unwrap_or_else(|| {
                    let nothing = DMatrix::from_element(n, n + 1, f64::NAN);
                    (nothing.column(0).into_owned(), nothing)
                });
            return LinearisedRates {
                rates,
                by_state: slopes.columns(0, n).into_owned(),
                by_parameter: slopes.column(n).into_owned(),
            };
        }
        let mut found = LinearisedRates {
            rates: DVector::zeros(n),
            by_state: DMatrix::zeros(n, n),
            by_parameter: DVector::zeros(n),
        };
        self.varied.visit(&arguments, |(row, column), value| match column {
            0 => found.rates[row] = value,
            column if column <= n => found.by_state[(row, column - 1)] = value,
            _ => found.by_parameter[row] = value,
        });
        found
    }

    /// The evaluations of the right sides so far, each counted as often as there are motions and variations.
    pub(super) fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    fn count(&self, columns: usize) {
        self.evaluations.set(self.evaluations.get() + columns as u64);
    }

    fn options(&self, length: f64, smooth: bool) -> IntegrationOptions {
        /// Least number of steps where a corner may lie between them.
        const STEPS_WITH_CORNERS: f64 = 100.0;
        IntegrationOptions {
            maximum_steps: STEPS,
            maximum_step: if smooth { f64::INFINITY } else { length / STEPS_WITH_CORNERS },
            interrupt: self.interrupt,
            ..IntegrationOptions::with_tolerance(TOLERANCE)
        }
    }

    /// The state at the end of a time; `None` if it is not reached.
    pub(super) fn end(
        &self,
        start: &[f64],
        [from, to]: [f64; 2],
        parameter: f64,
        sizes: &[f64],
    ) -> Option<Vec<f64>> {
        let n = self.states;
        if let Some(jumps) = &self.jumps {
            let run = self.sliding(jumps, start, [from, to], parameter, sizes, None)?;
            return Some(run.values.iter().zip(sizes).map(|(value, size)| value * size).collect());
        }
        let prepared = self.prepared.take().filter(|(known, _)| *known == parameter);
        let own = match prepared {
            Some((_, known)) => known.in_sizes(sizes),
            None => ScaledRates::new(&self.rates, None, &[parameter], sizes),
        };
        let memory = RefCell::new(vec![0.0; n + 2]);
        let rates = |time: f64, scaled: &Vec<f64>, rates: &mut Vec<f64>| {
            self.count(1);
            let arguments = &mut *memory.borrow_mut();
            set_states(scaled, sizes, time, arguments);
            own.write(arguments, scaled, rates);
        };
        let scaled = start.iter().zip(sizes).map(|(value, size)| value / size).collect();
        let options = IntegrationOptions {
            first_step: self.next_step.replace(0.0),
            ..self.options(to - from, self.smooth)
        };
        let start = Point { t: from, y: scaled };
        let end = end_or_event(rates, 0, start, to, &[], &options)?;
        self.next_step.set(end.next_step);
        self.prepared.replace(Some((parameter, own)));
        Some(end.point.y.iter().zip(sizes).map(|(value, size)| value * size).collect())
    }

    /// The motion between two times, with its derivatives; `None` if the end is not reached.
    pub(super) fn image(
        &self,
        start: &[f64],
        [from, to]: [f64; 2],
        parameter: f64,
        sizes: &[f64],
    ) -> Option<FlowImage> {
        let n = self.states;
        if let Some(jumps) = &self.jumps {
            let unit = Some(UNIT_OF_VARIATIONS);
            let run = self.sliding(jumps, start, [from, to], parameter, sizes, unit)?;
            let [low, high] = &run.bounds;
            let encounters = Encounters {
                stuck: run.stuck / (to - from),
                impacts: run.impacts,
                rests: run.rests,
                events: run.events,
                slowest: run.slowest,
                places: jumps.places_on(&run.throughout),
                times: run.times,
            };
            return Some(FlowImage { encounters, ..image_of(n, &run.values, sizes, low, high) });
        }
        // A row of the variations of each state, by all states and by the parameter.
        let width = n + 1;
        let varied = (&self.varied, UNIT_OF_VARIATIONS);
        let own = ScaledRates::new(&self.rates, Some(varied), &[parameter], sizes);
        let memory = RefCell::new(vec![0.0; n + 2]);
        let bounds = RefCell::new((start.to_vec(), start.to_vec()));
        // Within a step the states alone are asked for, whose bounds these are.
        let rates = |time: f64, scaled: &Vec<f64>, rates: &mut Vec<f64>| {
            self.count(if own.are_alone(scaled.len()) { 1 } else { 1 + width });
            let arguments = &mut *memory.borrow_mut();
            let (low, high) = &mut *bounds.borrow_mut();
            set_states(scaled, sizes, time, arguments);
            for (state, (low, high)) in arguments.iter().zip(low.iter_mut().zip(high)) {
                *low = low.min(*state);
                *high = high.max(*state);
            }
            own.write(arguments, scaled, rates);
        };
        let mut begin: Vec<f64> =
            start.iter().zip(sizes).map(|(value, size)| value / size).collect();
        begin.resize(n + n * width, 0.0);
        for i in 0..n {
            begin[n + i * width + i] = UNIT_OF_VARIATIONS;
        }
        let options = self.options(to - from, self.smooth);
        let start = Point { t: from, y: begin };
        let end = end_or_event(rates, n, start, to, &[], &options)?;
        let (low, high) = bounds.into_inner();
        Some(image_of(n, &end.point.y, sizes, &low, &high))
    }
}

/// Writes the states, which these values count in their sizes, and the time behind them.
pub(super) fn set_states(values: &[f64], sizes: &[f64], time: f64, arguments: &mut [f64]) {
    for (argument, (value, size)) in arguments.iter_mut().zip(values.iter().zip(sizes)) {
        *argument = value * size;
    }
    arguments[sizes.len()] = time;
}

/// The motion with these values at its end, states and variations in the sizes of the states, and these
/// lowest and highest values of the states.
fn image_of(n: usize, end: &[f64], sizes: &[f64], low: &[f64], high: &[f64]) -> FlowImage {
    let varied = |row: usize, column: usize| {
        end[n + row * (n + 1) + column] * (sizes[row] / UNIT_OF_VARIATIONS)
    };
    FlowImage {
        end: DVector::from_iterator(n, (0..n).map(|i| end[i] * sizes[i])),
        by_start: DMatrix::from_fn(n, n, |i, j| varied(i, j) / sizes[j]),
        by_parameter: DVector::from_iterator(n, (0..n).map(|i| varied(i, n))),
        travel: low.iter().zip(high).map(|(low, high)| 0.5 * (high - low)).collect(),
        encounters: Encounters::NONE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x' = p x + y, y' = -2 y from (1, 1): y = exp(-2 t), x = ((3 + p) exp(p t) - exp(-2 t))/(2 + p).
    #[test]
    fn a_linear_flow_has_its_closed_form() {
        let names: Vec<Symbol> = vec!["x".into(), "y".into()];
        let right = ["p*x + y", "-2*y"].map(|text| text.parse::<Expr>().expect(text));
        let flow = Flow::new(&names, "t".into(), &right, "p".into(), &[]).expect("a flow");
        let exact = |p: f64, t: f64| ((3.0 + p) * (p * t).exp() - (-2.0 * t).exp()) / (2.0 + p);
        let (p, t) = (0.3, 1.7);
        let image = flow.image(&[1.0, 1.0], [0.0, t], p, &[1.0, 3.0]).expect("an end");
        let step = 1e-5;
        let by_parameter = (exact(p + step, t) - exact(p - step, t)) / (2.0 * step);
        assert!((image.end[0] / exact(p, t) - 1.0).abs() < 1e-11, "{image:?}");
        assert!((image.by_start[(0, 0)] - (p * t).exp()).abs() < 1e-11);
        assert!((image.by_start[(1, 1)] - (-2.0 * t).exp()).abs() < 1e-11);
        let across = ((p * t).exp() - (-2.0 * t).exp()) / (2.0 + p);
        assert!((image.by_start[(0, 1)] - across).abs() < 1e-11);
        assert!((image.by_parameter[0] - by_parameter).abs() < 1e-8);
        let end = flow.end(&[1.0, 1.0], [0.0, t], p, &[1.0, 1.0]).expect("an end");
        assert!((end[0] / exact(p, t) - 1.0).abs() < 1e-11);
    }

    /// A mass with the acceleration 1 away from a spring with a dashpot at x = 0 that pulls, which it touches with
    /// the speed v: in contact x = 1/K + exp(-b t) (C cos(w t) + S sin(w t)), until x = 0.
    #[test]
    fn a_contact_of_any_depth_has_its_closed_form() {
        let (stiffness, damping) = (1e4_f64, 20.0);
        let names: Vec<Symbol> = vec!["x".into(), "v".into()];
        let right = ["v", "1 - H(-x)*(10000*x + 20*v)"];
        let right = right.map(|text| text.parse::<Expr>().expect(text));
        let flow = Flow::new(&names, "t".into(), &right, "p".into(), &[]).expect("a flow");
        let (b, w) = (0.5 * damping, (stiffness - 0.25 * damping * damping).sqrt());
        for speed in [1e-4_f64, 1e-3, 3e-3, 0.01, 0.03, 0.1, 1.0] {
            let contact = |t: f64| {
                let (cosine, sine) = (-1.0 / stiffness, (-b / stiffness - speed) / w);
                let (s, c) = (w * t).sin_cos();
                let decay = (-b * t).exp();
                let x = 1.0 / stiffness + decay * (cosine * c + sine * s);
                (x, decay * ((w * sine - b * cosine) * c - (w * cosine + b * sine) * s))
            };
            let step = 1e-4 * speed.min(1.0 / w);
            let back = (2..1_000_000).find(|k| contact(f64::from(*k) * step).0 > 0.0);
            let back = f64::from(back.expect("an end"));
            let ends = [(back - 1.0) * step, back * step];
            let end = crate::numeric::ode::root::find_root(|t| contact(t).0, ends[0], ends[1]);
            let end = end.expect("a root");
            let leaving = contact(end).1;
            // A time of one before the touch and behind the contact.
            let start = [speed + 0.5, -speed - 1.0];
            let found = flow.end(&start, [0.0, 2.0 + end], 0.0, &[1.0, 1.0]).expect("a run");
            let expected = [leaving + 0.5, leaving + 1.0];
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9, "{speed}: {found:?}, {expected}");
            }
        }
    }
}

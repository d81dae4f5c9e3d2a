//! One run by Taylor series: the length of a step, the events in it, and the next phase.
//!
//! In: a model, a start and settings that have been checked. Out: a [`Simulation`], from one run
//! alone (`simulate_one`) or from eight side by side (`lanes`), the same to the last bit. The coefficients
//! of a step come from `recurrences`.
//!
//! ```text
//! step:    (h/r)^(p+1) <= tolerance, 1/r = max |v_n|^(1/n) over the last coefficients of the velocity, n = p-4 ... p
//! turn:    v = 0, every change of sign in the step; between two of them x only rises or only falls
//! touch:   x = x_r on a rising part that ends beyond it: whether there is one is decided at the turning point, where
//!          x is known best, so grazing contacts are neither missed nor invented
//! onset:   from rest on the barrier into it; w = 0, v = 0 is a standstill of the regularised equation, so the first
//!          moment is free flight, until the contact force begins to count: v - F t/(3k/2 + 1), d ~ t^k, F ~ d^(3/2)
//! release: w = 0 on a falling part
//! stick:   v = 0 and |all other forces| <= alpha, until they exceed it
//! ```
//!
//! A [`Runner`] says which series it needs next ([`Runner::next_equation`], [`Runner::inputs`]) and
//! is given its coefficients ([`Runner::advance`]), whether these are computed for one motion or
//! for several side by side. What happens in most steps, a turning point and a touch or a release,
//! is found side by side too, in `course`; other events that may end a step are in `flight` and
//! `contact`, dry friction at a turning point in `friction`, the length of a step in `step` and
//! `stretch`, sine and cosine for several motions in `angle`.

mod angle;
mod contact;
mod course;
mod flight;
mod friction;
mod kernels;
mod lanes;
mod recurrences;
mod series;
mod step;
mod stretch;

use std::f64::consts::FRAC_2_PI;

use super::model::{Friction, Model, Side, Start};
use super::polynomial::{Roots, near_sign_changes};
use super::simulation::{
    ContactRecord, Integrator, REST_FRACTION, Regime, Settings, Simulation, SimulationPath,
    SimulationStop, TurningPoint, begin_contact, first_swing, has_rested, scaled,
};
use angle::sine_and_cosine;
use course::{Courses, StepEvents, courses};
pub(super) use lanes::follow;
use series::{HIGHEST_ORDER, Inputs, SeriesCoefficients, StepEndState, Terms};
use step::step_lengths;

/// The longest step in time, because a motion at rest has no scale of its own.
const LONGEST_STEP: f64 = 2.0;

/// The part of the tolerance that the first term left out may use up: from one contact to the next
/// there are a dozen steps, whose errors add up, and each contact multiplies them.
const SAFETY: f64 = 0.01;

/// The longest step in contact, in units of its own scale.
const LONGEST_CONTACT_STEP: f64 = 64.0;

/// The part of the velocity that the contact force may have taken when a contact that begins from
/// rest is handed to the equation of the contact: its first-order effect is subtracted then, so
/// that the error is of second order.
const LIGHT: f64 = 1e-8;

/// The slowest touch: below this the fourth power of w, the root of the depth, would underflow.
const SLOWEST_TOUCH: f64 = 1e-75;

/// A speed below this counts as zero.
const VANISHING: f64 = 1e-280;

/// Events in a row without progress of time after which a run is called stalled.
const MOST_IDLE: usize = 100;

/// Number of contacts for which memory is reserved.
const FEW: usize = 8;

/// The coefficients of a step of one motion: x or w, v, t.
type Loaded = [[f64; HIGHEST_ORDER + 1]; 3];

/// The equation of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum StepEquation {
    Flight,
    Contact,
}

/// One run and its present state.
pub(super) struct Runner {
    model: Model,
    settings: Settings,
    order: usize,
    terms: Terms,
    regime: Regime,
    t: f64,
    /// x in flight, w in contact; in contact it and the velocity are mirrored to a right barrier.
    place: f64,
    velocity: f64,
    sine: f64,
    cosine: f64,
    /// Sine and cosine of the barriers, the left one first.
    angles: [(f64, f64); 2],
    /// Coulomb friction alone: the direction of the motion.
    direction: f64,
    /// Whether friction has just released the pendulum, so that the acceleration is still zero.
    released: bool,
    unit: f64,
    /// In contact: the mirrored position of the barrier; otherwise 0.
    base: f64,
    /// In contact: the largest w and the largest speed of Hertz's contact that begins so.
    hertz: [f64; 2],
    /// The step under way: how long the series is good for, and how much of that is taken.
    proposed: f64,
    length: f64,
    steps: usize,
    idle: usize,
    stop: Option<SimulationStop>,
    /// A tenth of the amplitude of the first swing.
    level: f64,
    impacts: Vec<ContactRecord>,
    turns: Vec<TurningPoint>,
    path: SimulationPath,
}

/// The event that ends a step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum StepEvent {
    Turn,
    Touch(Side),
    /// A turning point on the barrier itself, from which the contact begins from rest.
    Settle(Side),
    /// The onset of the contact force after a motion from rest on the barrier into it.
    Onset(Side),
    Release,
    /// The contact would begin to pull.
    Detach,
    /// The barrier has returned and presses again.
    Reattach,
    RestEnergy,
}

/// One motion from its start to its end.
pub(super) fn simulate_one(model: Model, start: Start, settings: Settings) -> Simulation {
    let mut runner = Runner::new(model, start, settings);
    let mut series = SeriesCoefficients::<1>::new();
    let mut inputs = Inputs::<1>::new();
    let mut found = Courses::<1>::new();
    let (order, terms) = (runner.order(), runner.terms());
    while let Some(equation) = runner.next_equation() {
        runner.inputs(0, &mut inputs);
        match equation {
            StepEquation::Flight => recurrences::flight(&inputs, order, terms, &mut series),
            StepEquation::Contact => recurrences::contact(&inputs, order, terms, &mut series),
        }
        let [proposed] = step_lengths(&series.velocity, order, &inputs.size, &inputs.allowed);
        let length = runner.step_length(proposed);
        let ends = series.ends(&inputs, &[length], order, equation);
        courses(&series, (order, equation), &inputs, &[length], &ends, &mut found);
        runner.advance(ends.lane(0), found.lane(0), || series.lane(order, 0));
    }
    runner.finish(start)
}

/// The time of the fall to a tenth of the first swing, if that may be the rest time and no path
/// gives it: that part of the motion is computed with its path. `None` if it is not needed.
pub(super) fn time_of_fall_by_series(simulation: &Simulation) -> Option<f64> {
    let from = simulation.untold_fall()?;
    let start = match from.t > 0.0 {
        true => Start { x: from.x, velocity: 0.0 },
        false => simulation.start,
    };
    let settings =
        Settings { duration: simulation.end_time - from.t, keep_path: true, ..simulation.settings };
    if settings.duration <= 0.0 {
        return None;
    }
    let again = simulate_one(simulation.model, start, settings);
    let level = REST_FRACTION * first_swing(&simulation.model, simulation.start);
    let fall = again.time_of_fall(TurningPoint { t: 0.0, x: start.x }, level)?;
    Some(from.t + fall)
}

/// The order of the series that suits a tolerance. Most of the work of a step is not that of its
/// series, so long steps pay, and the order hardly depends on it.
fn order_for(tolerance: f64) -> usize {
    let digits = -tolerance.max(1e-18).log10();
    ((22.1 + 0.37 * digits) as usize).clamp(8, HIGHEST_ORDER)
}

impl Runner {
    /// A run from this start, which has been checked.
    pub(super) fn new(model: Model, start: Start, settings: Settings) -> Self {
        let settings = scaled(&settings, &model, start);
        let mut runner = Self {
            model,
            settings,
            order: order_for(settings.relative_tolerance),
            terms: Terms {
                arctangent: model.friction == Friction::Arctangent && model.alpha > 0.0,
                excited: model.beta != 0.0,
                damped_contact: model.mu > 0.0,
            },
            regime: Regime::Free,
            t: 0.0,
            place: start.x,
            velocity: start.velocity,
            sine: 0.0,
            cosine: 0.0,
            angles: [model.left, model.right]
                .map(|barrier| sine_and_cosine(barrier.unwrap_or_default())),
            direction: 0.0,
            released: false,
            unit: 1.0,
            base: 0.0,
            hertz: [0.0; 2],
            proposed: 0.0,
            length: 0.0,
            steps: 0,
            idle: 0,
            stop: None,
            level: REST_FRACTION * first_swing(&model, start),
            impacts: Vec::with_capacity(FEW),
            turns: Vec::with_capacity(4 * FEW),
            path: SimulationPath::new(),
        };
        runner.fly();
        if start.velocity == 0.0 {
            runner.turns.push(TurningPoint { t: 0.0, x: start.x });
        }
        for side in [Side::Left, Side::Right] {
            if model.barrier(side) == Some(start.x) && side.sign() * start.velocity > 0.0 {
                runner.touch(side, side.sign() * start.velocity);
            }
        }
        if let Some((side, depth)) = model.depth(start.x) {
            let speed = side.sign() * start.velocity;
            begin_contact(&mut runner.impacts, (&model, &settings), side, 0.0, [depth, speed]);
            match model.would_pull(speed) {
                true => runner.regime = Regime::Detached(side),
                false => runner.enter_contact(side, depth.sqrt(), speed),
            }
        }
        if model.sticks() {
            match start.velocity {
                0.0 => runner.turn(),
                velocity => runner.direction = velocity.signum(),
            }
        }
        if settings
            .rest_energy
            .is_some_and(|energy| model.energy(start.x, start.velocity) <= energy)
        {
            runner.stop = Some(SimulationStop::RestEnergy);
        }
        runner
    }

    /// Returns the simulation at the end of the run.
    pub(super) fn finish(self, start: Start) -> Simulation {
        let (end_time, end_x, end_velocity) = self.now();
        let mut simulation = Simulation {
            model: self.model,
            start,
            settings: self.settings,
            integrator: Integrator::Taylor,
            path: self.path,
            impacts: self.impacts,
            turns: self.turns,
            end_time,
            end_x,
            end_velocity,
            stop: self.stop.unwrap_or(SimulationStop::Duration),
            steps: self.steps,
            fall: None,
        };
        simulation.fall = time_of_fall_by_series(&simulation);
        simulation
    }

    /// The present time, displacement and velocity.
    fn now(&self) -> (f64, f64, f64) {
        match self.side() {
            Some((side, barrier)) if matches!(self.regime, Regime::Contact(_)) => (
                self.t,
                barrier + side.sign() * self.place * self.place,
                side.sign() * self.velocity,
            ),
            _ => (self.t, self.place, self.velocity),
        }
    }

    /// The order of the series that it needs.
    fn order(&self) -> usize {
        self.order
    }

    /// The terms of the equation that are on.
    fn terms(&self) -> Terms {
        self.terms
    }

    /// The series needed next; `None` once the run has ended.
    fn next_equation(&mut self) -> Option<StepEquation> {
        if self.stop.is_some() {
            return None;
        }
        if self.t >= self.settings.duration {
            self.stop = Some(SimulationStop::Duration);
            return None;
        }
        if self.steps >= self.settings.maximum_steps {
            self.stop = Some(SimulationStop::Steps { t: self.t });
            return None;
        }
        if self.settings.interrupt.is_requested() {
            self.stop = Some(SimulationStop::Interrupted { t: self.t });
            return None;
        }
        self.steps += 1;
        match self.regime {
            Regime::Contact(_) => Some(StepEquation::Contact),
            _ => Some(StepEquation::Flight),
        }
    }

    /// Writes the present state into one lane.
    fn inputs<const L: usize>(&self, lane: usize, inputs: &mut Inputs<L>) {
        let model = &self.model;
        let mirror = match self.regime {
            Regime::Contact(side) => side.sign(),
            _ => 1.0,
        };
        let arctangent = model.friction == Friction::Arctangent;
        inputs.place[lane] = self.place;
        inputs.base[lane] = self.base;
        inputs.velocity[lane] = self.velocity;
        inputs.sine[lane] = mirror * self.sine;
        inputs.cosine[lane] = self.cosine;
        if model.beta != 0.0 {
            let (sine, cosine) = (model.frequency_ratio * self.t).sin_cos();
            inputs.drive[0][lane] = sine;
            inputs.drive[1][lane] = cosine;
        }
        inputs.unit[lane] = self.unit;
        (inputs.hertz[0][lane], inputs.hertz[1][lane]) = (self.hertz[0], self.hertz[1]);
        inputs.dry[lane] = if arctangent { 0.0 } else { model.alpha * mirror * self.direction };
        inputs.arctangent[lane] = if arctangent { FRAC_2_PI * model.alpha } else { 0.0 };
        inputs.viscous[lane] = 2.0 * model.zeta;
        inputs.beta[lane] = mirror * model.beta;
        inputs.eta[lane] = model.frequency_ratio;
        inputs.gamma[lane] = model.gamma;
        inputs.mu[lane] = model.mu;
        (inputs.size[lane], inputs.allowed[lane]) = self.allowance();
        (inputs.lower[lane], inputs.upper[lane]) = match self.regime {
            Regime::Contact(_) => (0.0, f64::INFINITY),
            _ => (model.left.unwrap_or(f64::NEG_INFINITY), model.right.unwrap_or(f64::INFINITY)),
        };
    }

    /// The size of the motion now, and the bound of the first term left out of a step.
    fn allowance(&self) -> (f64, f64) {
        let tolerance = &self.settings;
        let place = match self.regime {
            Regime::Contact(_) => self.impacts.last().map_or(0.0, |impact| impact.speed_in),
            _ => self.place.abs(),
        };
        let size = place.max(self.velocity.abs()).max(tolerance.absolute_tolerance);
        let allowed = SAFETY * (tolerance.absolute_tolerance + tolerance.relative_tolerance * size);
        (size, allowed)
    }

    /// The length of the step in its unit, limited to the reach of the series.
    fn step_length(&mut self, proposed: f64) -> f64 {
        self.proposed = proposed;
        let longest = match self.regime {
            Regime::Contact(_) => LONGEST_CONTACT_STEP,
            _ => LONGEST_STEP / self.unit,
        };
        self.length = proposed.min(longest);
        self.length
    }

    /// Takes the next step of the series: from its values at the end of the step, and, if they do
    /// not suffice, from its coefficients: x and v, or w, v and t.
    fn advance(
        &mut self,
        end: StepEndState,
        course: Option<StepEvents>,
        load: impl Fn() -> Loaded,
    ) {
        let (before, turns) = (self.t, self.turns.len());
        if !(end.place.is_finite() && end.variation.is_finite()) {
            self.stop = Some(SimulationStop::NotFinite { t: self.t });
            return;
        }
        let contact = self.side().filter(|_| matches!(self.regime, Regime::Contact(_)));
        if contact.is_none() && self.t + end.time.min(self.settings.duration - self.t) <= self.t {
            self.stop = Some(SimulationStop::StepTooSmall { t: self.t });
            return;
        }
        let plain = course.filter(|course| {
            let sticks = course.turn.is_some() && self.model.sticks();
            !(sticks || self.released)
        });
        let done = plain.is_some_and(|course| match contact {
            Some(contact) => self.press_on(contact, end, course, &load),
            None => self.fly_on(end, course, &load),
        });
        if !done {
            let [mut place, mut velocity, time] = load();
            if self.released {
                (velocity[1], place[2]) = (0.0, 0.0);
            }
            self.released = false;
            match contact {
                Some(contact) => self.advance_contact(contact, end, [&place, &velocity, &time]),
                None => self.advance_flight(end, [&place, &velocity, &time]),
            }
        }
        let turned = self.settings.stop_at_rest && self.turns.len() > turns;
        if turned && self.stop.is_none() && has_rested(&self.model, &self.turns, self.level) {
            self.stop = Some(SimulationStop::AtRest);
        }
        self.idle = if self.t > before { 0 } else { self.idle + 1 };
        if self.idle > MOST_IDLE && self.stop.is_none() {
            self.stop = Some(SimulationStop::Stalled { t: self.t });
        }
    }

    /// Whether the energy of the swing alone is at most the rest energy.
    fn is_at_rest_energy(&self, velocity: f64, cosine: f64) -> bool {
        self.settings
            .rest_energy
            .is_some_and(|rest_energy| 0.5 * velocity * velocity + (1.0 - cosine) <= rest_energy)
    }

    fn side(&self) -> Option<(Side, f64)> {
        match self.regime {
            Regime::Contact(side) | Regime::Detached(side) => {
                Some((side, self.model.barrier(side)?))
            }
            _ => None,
        }
    }

    /// Ends the run at the present state; turning points noted in the rest of the step are no
    /// longer part of it.
    fn end_at_rest_energy(&mut self) {
        self.stop = Some(SimulationStop::RestEnergy);
        while self.turns.last().is_some_and(|turn| turn.t > self.t) {
            self.turns.pop();
        }
    }

    fn set_angle(&mut self, x: f64) {
        (self.sine, self.cosine) = self.angle(x);
    }

    /// Sine and cosine of a barrier.
    fn angle_at(&self, side: Side) -> (f64, f64) {
        match side {
            Side::Left => self.angles[0],
            Side::Right => self.angles[1],
        }
    }

    /// Sine and cosine of x; those of the barriers are known.
    fn angle(&self, x: f64) -> (f64, f64) {
        match x {
            _ if self.model.right == Some(x) => self.angles[1],
            _ if self.model.left == Some(x) => self.angles[0],
            _ => sine_and_cosine(x),
        }
    }

    /// Adapts the unit to the length of the steps.
    fn adapt(&mut self) {
        let proposed = self.proposed;
        if !(0.125..=8.0).contains(&proposed) && proposed.is_finite() {
            let in_contact = matches!(self.regime, Regime::Contact(_));
            let unit = self.unit * proposed.min(LONGEST_CONTACT_STEP);
            if unit > 0.0 && (unit <= LONGEST_STEP || in_contact && unit.is_finite()) {
                self.unit = unit;
            }
        }
    }
}

/// Sign changes of the velocity.
fn turning_points(v: &[f64], h: f64, end: StepEndState) -> Roots {
    // A motion at the edge of underflow has come to rest.
    if v[0].abs() > end.variation || end.variation < VANISHING {
        return Roots::new();
    }
    near_sign_changes(v, h, end.velocity)
}

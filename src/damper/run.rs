//! One run by Taylor series: how far a step reaches, what happens in it, and what comes next.
//!
//! ```text
//! step:    (h/r)^(p+1) <= tolerance, 1/r = max |v_n|^(1/n) over the last coefficients of the velocity, n = p-4 ... p
//! turn:    v = 0, every change of sign in the step; between two of them x only rises or only falls
//! touch:   x = x_r on a rising part that ends beyond it: whether there is one is decided at the turning point, where
//!          x is known best, so grazing contacts are neither missed nor invented
//! lean:    from rest on the barrier into it; w = 0, v = 0 is a standstill of the regularised equation, so the first
//!          moment is free flight, until the contact force begins to count: v - F t/(3k/2 + 1), d ~ t^k, F ~ d^(3/2)
//! release: w = 0 on a falling part
//! stick:   v = 0 and |all other forces| <= alpha, until they exceed it
//! ```
//!
//! A [`Runner`] says which series it needs next ([`Runner::wants`], [`Runner::moment`]) and is given its coefficients
//! ([`Runner::advance`]); who computes them, for one motion or for several side by side, it does not know.

use std::f64::consts::{FRAC_2_PI, PI, TAU};

use super::model::{Friction, Model, Side, Start};
use super::path::{Path, State};
use super::polynomial::{
    Roots, bracketed, crossing_of, level_crossing, near_sign_changes, sign_changes, value, variation,
};
use super::taylor::{Coefficients, End, HIGHEST_ORDER, INVERSE, LAST, Moment, Terms, contact, flight};
use super::{Impact, Integrator, Options, Simulation, Stop, Turn, enter, scaled};

/// The longest step in time, for a motion at rest has no scale of its own.
const LONGEST_STEP: f64 = 2.0;

/// The part of the tolerance that the first term left out may use up; those after it add as much again.
const SAFETY: f64 = 0.5;

/// The longest step in contact, in units of its own scale.
const LONGEST_CONTACT_STEP: f64 = 64.0;

/// The part of the velocity that the contact force may have taken when a motion that leans on a barrier is handed to the
/// equation of the contact: its first order is taken off then, so what is left out is the square of it.
const LIGHT: f64 = 1e-8;

/// A touch slower than this is none: in contact the fourth power of w, the root of the depth, would be lost.
const SLOWEST_TOUCH: f64 = 1e-75;

/// A speed that is none.
const VANISHING: f64 = 1e-280;

/// Events in a row without progress of time after which a run is called stalled.
const MOST_IDLE: usize = 100;

/// Which series is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Equation {
    Flight,
    Contact,
}

/// One run and where it is.
pub(super) struct Runner {
    model: Model,
    options: Options,
    order: usize,
    state: State,
    t: f64,
    /// x in flight, w in contact, where it and the velocity are seen in the mirror of the side.
    place: f64,
    velocity: f64,
    sine: f64,
    cosine: f64,
    /// Coulomb friction alone: the direction of the motion.
    direction: f64,
    /// Let go by friction just now: the acceleration is still zero.
    released: bool,
    unit: f64,
    /// The step under way: how long the series is good for, how much of that is taken, and whether it is the last.
    proposed: f64,
    length: f64,
    last: bool,
    steps: usize,
    idle: usize,
    pub(super) stop: Option<Stop>,
    pub(super) impacts: Vec<Impact>,
    pub(super) turns: Vec<Turn>,
    pub(super) path: Path,
}

/// What ends a step before its time.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Event {
    Turn,
    Touch(Side),
    /// Turned on the barrier and pushed in: at rest there, from where it leans.
    Settle(Side),
    /// From rest on the barrier into it, far enough for the contact force to begin to count.
    Lean(Side),
    Release,
    /// The contact would begin to pull.
    Detach,
    /// The barrier has come back and presses again.
    Reattach,
    Calm,
}

/// One motion from its start to its end.
pub(super) fn alone(model: Model, start: Start, options: Options) -> Simulation {
    let mut runner = Runner::new(model, start, options);
    let mut series = Coefficients::<1>::new();
    let mut moment = Moment::<1>::new();
    let (order, terms) = (runner.order(), runner.terms());
    while let Some(equation) = runner.wants() {
        runner.moment(0, &mut moment);
        match equation {
            Equation::Flight => flight(&moment, order, terms, &mut series),
            Equation::Contact => contact(&moment, order, terms, &mut series),
        }
        let length = runner.reach(series.last(order, 0));
        let ends = series.ends(&[length], order);
        runner.advance(ends.lane(0), || series.lane(order, 0));
    }
    runner.finish(start)
}

/// The order of the series that suits a tolerance: each order gains about a third of a digit per step.
pub(super) fn order_for(tolerance: f64) -> usize {
    let digits = -tolerance.max(1e-18).log10();
    ((6.5 + 1.6 * digits) as usize).clamp(8, HIGHEST_ORDER)
}

impl Runner {
    /// A run from this start, which has been checked.
    pub(super) fn new(model: Model, start: Start, options: Options) -> Self {
        let options = scaled(&options, &model, start);
        let mut runner = Self {
            model,
            options,
            order: order_for(options.relative_tolerance),
            state: State::Free,
            t: 0.0,
            place: start.x,
            velocity: start.velocity,
            sine: 0.0,
            cosine: 0.0,
            direction: 0.0,
            released: false,
            unit: 1.0,
            proposed: 0.0,
            length: 0.0,
            last: false,
            steps: 0,
            idle: 0,
            stop: None,
            impacts: Vec::new(),
            turns: Vec::new(),
            path: Path::new(),
        };
        runner.fly();
        if start.velocity == 0.0 {
            runner.turns.push(Turn { t: 0.0, x: start.x });
        }
        for side in [Side::Left, Side::Right] {
            if model.barrier(side) == Some(start.x) && side.sign() * start.velocity > 0.0 {
                runner.touch(side, side.sign() * start.velocity);
            }
        }
        if let Some((side, depth)) = model.depth(start.x) {
            let speed = side.sign() * start.velocity;
            enter(&mut runner.impacts, (&model, &options), side, 0.0, [depth, speed]);
            match model.would_pull(speed) {
                true => runner.state = State::Detached(side),
                false => runner.press(side, depth.sqrt(), speed),
            }
        }
        if model.sticks() {
            match start.velocity {
                0.0 => runner.turn(),
                velocity => runner.direction = velocity.signum(),
            }
        }
        if options
            .rest_energy
            .is_some_and(|energy| model.energy(start.x, start.velocity) <= energy)
        {
            runner.stop = Some(Stop::Calm);
        }
        runner
    }

    /// What came of it.
    pub(super) fn finish(self, start: Start) -> Simulation {
        let (end_time, end_x, end_velocity) = self.now();
        Simulation {
            model: self.model,
            start,
            options: self.options,
            integrator: Integrator::Taylor,
            path: self.path,
            impacts: self.impacts,
            turns: self.turns,
            end_time,
            end_x,
            end_velocity,
            stop: self.stop.unwrap_or(Stop::Duration),
            steps: self.steps,
        }
    }

    /// Time, displacement and velocity now.
    pub(super) fn now(&self) -> (f64, f64, f64) {
        match self.side() {
            Some((side, barrier)) if matches!(self.state, State::Contact(_)) => (
                self.t,
                barrier + side.sign() * self.place * self.place,
                side.sign() * self.velocity,
            ),
            _ => (self.t, self.place, self.velocity),
        }
    }

    /// The order of the series it wants.
    pub(super) fn order(&self) -> usize {
        self.order
    }

    /// The terms of the equation that are on.
    pub(super) fn terms(&self) -> Terms {
        Terms {
            arctangent: self.model.friction == Friction::Arctangent && self.model.alpha > 0.0,
            excited: self.model.beta != 0.0,
            damped_contact: self.model.mu > 0.0,
        }
    }

    /// The series wanted next; nothing once the run has ended.
    pub(super) fn wants(&mut self) -> Option<Equation> {
        if self.stop.is_some() {
            return None;
        }
        if self.t >= self.options.duration {
            self.stop = Some(Stop::Duration);
            return None;
        }
        if self.steps >= self.options.maximum_steps {
            self.stop = Some(Stop::Steps { t: self.t });
            return None;
        }
        if self.options.interrupt.is_requested() {
            self.stop = Some(Stop::Interrupted { t: self.t });
            return None;
        }
        self.steps += 1;
        match self.state {
            State::Contact(_) => Some(Equation::Contact),
            _ => Some(Equation::Flight),
        }
    }

    /// Writes the present moment into one lane.
    pub(super) fn moment<const L: usize>(&self, lane: usize, moment: &mut Moment<L>) {
        let model = &self.model;
        let mirror = match self.state {
            State::Contact(side) => side.sign(),
            _ => 1.0,
        };
        let arctangent = model.friction == Friction::Arctangent;
        moment.place[lane] = self.place;
        moment.velocity[lane] = self.velocity;
        moment.sine[lane] = mirror * self.sine;
        moment.cosine[lane] = self.cosine;
        if model.beta != 0.0 {
            let (sine, cosine) = (model.frequency_ratio * self.t).sin_cos();
            moment.drive[0][lane] = sine;
            moment.drive[1][lane] = cosine;
        }
        moment.unit[lane] = self.unit;
        moment.dry[lane] = if arctangent {
            0.0
        } else {
            model.alpha * mirror * self.direction
        };
        moment.arctangent[lane] = if arctangent { FRAC_2_PI * model.alpha } else { 0.0 };
        moment.viscous[lane] = 2.0 * model.zeta;
        moment.beta[lane] = mirror * model.beta;
        moment.eta[lane] = model.frequency_ratio;
        moment.gamma[lane] = model.gamma;
        moment.mu[lane] = model.mu;
    }

    /// How far the series reaches, in its unit: from the last coefficients of the velocity. The step ends there if
    /// nothing happens before.
    pub(super) fn reach(&mut self, last: [f64; LAST]) -> f64 {
        let tolerance = &self.options;
        if matches!(self.state, State::Contact(_)) {
            let entry = self.impacts.last().map_or(0.0, |impact| impact.speed_in);
            let size = entry.max(self.velocity.abs()).max(tolerance.absolute_tolerance);
            let allowed = SAFETY * (tolerance.relative_tolerance * size + tolerance.absolute_tolerance);
            self.proposed = step_length(size, allowed, last, self.order);
            self.length = self.proposed.min(LONGEST_CONTACT_STEP);
            self.last = false;
            return self.length;
        }
        let size = self
            .place
            .abs()
            .max(self.velocity.abs())
            .max(tolerance.absolute_tolerance);
        let allowed = SAFETY * (tolerance.absolute_tolerance + tolerance.relative_tolerance * size);
        self.proposed = step_length(size, allowed, last, self.order);
        let remaining = self.options.duration - self.t;
        let length = self.proposed.min(LONGEST_STEP / self.unit);
        self.last = length * self.unit >= remaining;
        self.length = if self.last { remaining / self.unit } else { length };
        self.length
    }

    /// Goes on with the series at the present moment: its values at the end of the step, and where they do not say
    /// enough, its coefficients: x and v, or w, v and t.
    pub(super) fn advance(&mut self, end: End, load: impl FnOnce() -> [[f64; HIGHEST_ORDER + 1]; 3]) {
        let before = self.t;
        if !(end.place.is_finite() && end.variation.is_finite()) {
            self.stop = Some(Stop::NotFinite { t: self.t });
            return;
        }
        let contact = self.side().filter(|_| matches!(self.state, State::Contact(_)));
        if contact.is_none() && !self.last && self.t + self.length * self.unit <= self.t {
            self.stop = Some(Stop::StepTooSmall { t: self.t });
            return;
        }
        let uneventful = match contact {
            Some(contact) => self.press_on(contact, end),
            None => self.fly_on(end),
        };
        if !uneventful {
            let [mut place, mut velocity, time] = load();
            if self.released {
                (velocity[1], place[2]) = (0.0, 0.0);
            }
            self.released = false;
            match contact {
                Some(contact) => self.advance_contact(contact, end, [&place, &velocity, &time]),
                None => self.advance_flight(end, &place, &velocity),
            }
        }
        self.idle = if self.t > before { 0 } else { self.idle + 1 };
        if self.idle > MOST_IDLE && self.stop.is_none() {
            self.stop = Some(Stop::Stalled { t: self.t });
        }
    }

    /// Takes a whole step of free flight if its ends show that nothing happens in it and nobody wants to see it.
    fn fly_on(&mut self, end: End) -> bool {
        let turns = self.velocity.abs() <= end.variation;
        let beyond = |side: Side| {
            self.model
                .barrier(side)
                .is_some_and(|barrier| side.sign() * (end.place - barrier) > 0.0)
        };
        if turns
            || self.options.keep_path
            || self.released
            || self.state != State::Free
            || beyond(Side::Left)
            || beyond(Side::Right)
        {
            return false;
        }
        let (sine, cosine) = end.place.sin_cos();
        if self.is_calm(end.velocity, cosine) {
            return false;
        }
        self.t = if self.last {
            self.options.duration
        } else {
            self.t + self.length * self.unit
        };
        (self.place, self.velocity, self.sine, self.cosine) = (end.place, end.velocity, sine, cosine);
        self.adapt();
        true
    }

    /// Takes a whole step in contact likewise.
    fn press_on(&mut self, (side, barrier): (Side, f64), end: End) -> bool {
        let turns = self.velocity.abs() <= end.variation;
        let lowest = self.velocity - end.variation;
        if turns
            || self.model.would_pull(lowest)
            || self.options.keep_path
            || self.released
            || end.place <= 0.0
            || self.options.duration - self.t <= end.time
        {
            return false;
        }
        let depth = end.place * end.place;
        let (sine, cosine) = (barrier + side.sign() * depth).sin_cos();
        // What is stored in the barrier comes on top.
        if self.is_calm(end.velocity, cosine) {
            return false;
        }
        if let Some(impact) = self.impacts.last_mut() {
            impact.penetration = impact.penetration.max(depth);
        }
        self.t += end.time.max(0.0);
        (self.place, self.velocity, self.sine, self.cosine) = (end.place, end.velocity, sine, cosine);
        self.adapt();
        true
    }

    /// Whether the swing alone has no more than the rest energy.
    fn is_calm(&self, velocity: f64, cosine: f64) -> bool {
        self.options
            .rest_energy
            .is_some_and(|calm| 0.5 * velocity * velocity + (1.0 - cosine) <= calm)
    }

    fn side(&self) -> Option<(Side, f64)> {
        match self.state {
            State::Contact(side) | State::Detached(side) => Some((side, self.model.barrier(side)?)),
            _ => None,
        }
    }

    fn advance_flight(&mut self, whole: End, x: &[f64], v: &[f64]) {
        let (x, v) = (&x[..=self.order], &v[..=self.order]);
        let h = self.length;
        let (mut end, mut event) = match self.state {
            State::Detached(side) => self.detached_event(side, x, v, h),
            _ => self.flight_event(x, v, h, whole),
        };
        let energy = |u: f64| self.model.energy(value(x, u), value(v, u));
        let (mut x_end, mut v_end) = if end == h {
            (whole.place, whole.velocity)
        } else {
            (value(x, end), value(v, end))
        };
        let (mut sine, mut cosine) = x_end.sin_cos();
        if let Some(calm) = self.options.rest_energy
            && self.is_calm(v_end, cosine)
            && matches!(self.state, State::Free)
        {
            end = crossing_of(|u| energy(u) - calm, 0.0, end);
            event = Some(Event::Calm);
            (x_end, v_end) = (value(x, end), value(v, end));
            (sine, cosine) = x_end.sin_cos();
        }
        let start = self.t;
        self.t = if self.last && end == h {
            self.options.duration
        } else {
            start + end * self.unit
        };
        if self.options.keep_path {
            let state = match event {
                Some(Event::Lean(side)) => State::Contact(side),
                _ => self.state,
            };
            self.path.push_flight([start, self.t], state, self.unit, x, v);
        }
        (self.place, self.velocity, self.sine, self.cosine) = (x_end, v_end, sine, cosine);
        self.adapt();
        match event {
            None => {}
            Some(Event::Turn) => {
                self.velocity = 0.0;
                self.turn();
            }
            Some(Event::Touch(side)) if v_end.abs() > SLOWEST_TOUCH => self.touch(side, side.sign() * v_end),
            Some(Event::Lean(side)) => {
                let depth = side.sign() * rise(x, end);
                enter(&mut self.impacts, (&self.model, &self.options), side, start, [0.0, 0.0]);
                self.lean(side, end * self.unit, [depth, side.sign() * v_end]);
            }
            Some(Event::Touch(side) | Event::Settle(side)) => {
                (self.place, self.velocity) = (self.model.barrier(side).unwrap_or(x_end), 0.0);
                self.fly();
            }
            Some(Event::Release) => self.leave(v_end),
            Some(Event::Reattach) => {
                if let State::Detached(side) = self.state {
                    let barrier = self.model.barrier(side).unwrap_or_default();
                    self.press(
                        side,
                        (side.sign() * (self.place - barrier)).max(0.0).sqrt(),
                        side.sign() * v_end,
                    );
                }
            }
            Some(Event::Calm) => self.calm(),
            Some(Event::Detach) => {}
        }
    }

    /// Ends the run where it is; turning points noted in the rest of the step are no longer part of it.
    fn calm(&mut self) {
        self.stop = Some(Stop::Calm);
        while self.turns.last().is_some_and(|turn| turn.t > self.t) {
            self.turns.pop();
        }
    }

    /// What ends a free flight before `h`, and where. Turning points on the way are noted.
    fn flight_event(&mut self, x: &[f64], v: &[f64], h: f64, end: End) -> (f64, Option<Event>) {
        let turns = turning_points(v, h, end);
        let (mut from, mut x_from) = (0.0, x[0]);
        let ends = turns.as_slice().iter().map(|turn| (*turn, true)).chain([(h, false)]);
        for (to, turning) in ends {
            let x_to = if turning { value(x, to) } else { end.place };
            for side in [Side::Right, Side::Left] {
                let sign = side.sign();
                // At rest on the barrier: which way it goes is in the change of x alone, not in x - x_r.
                if from == 0.0 && v[0] == 0.0 && self.model.barrier(side) == Some(x[0]) {
                    if sign * rise(x, to) > 0.0 {
                        return (self.onset(side, x, v, to), Some(Event::Lean(side)));
                    }
                    continue;
                }
                if let Some(barrier) = self.model.barrier(side)
                    && sign * (x_to - barrier) > 0.0
                {
                    let touch = if sign * (x_from - barrier) < 0.0 {
                        bracketed(x, barrier, (from, x_from - barrier), (to, x_to - barrier))
                    } else {
                        from
                    };
                    if sign * value(v, touch) > 0.0 {
                        return (touch, Some(Event::Touch(side)));
                    }
                    // Beyond it by more than rounding, and yet no speed: it turned on the barrier and is pushed in.
                    if sign * (x_to - barrier) > 8.0 * f64::EPSILON * barrier.abs().max(1.0) {
                        return (touch, Some(Event::Settle(side)));
                    }
                }
            }
            if turning {
                self.turns.push(Turn {
                    t: self.t + to * self.unit,
                    x: x_to,
                });
                if self.model.sticks() {
                    return (to, Some(Event::Turn));
                }
            }
            (from, x_from) = (to, x_to);
        }
        (h, None)
    }

    /// What ends the flight away from a barrier that is still behind: back in place, or as fast as the barrier.
    fn detached_event(&mut self, side: Side, x: &[f64], v: &[f64], h: f64) -> (f64, Option<Event>) {
        let barrier = self.model.barrier(side).unwrap_or_default();
        let sign = side.sign();
        let mut excess = [0.0; HIGHEST_ORDER + 1];
        for (entry, coefficient) in excess.iter_mut().zip(v) {
            *entry = sign * coefficient;
        }
        // It begins at the level or below it, whatever rounding says.
        excess[0] = (excess[0] + self.model.gamma / self.model.mu).min(0.0);
        let catches = sign_changes(&excess[..=self.order], h);
        let catch = catches.as_slice().first().copied().unwrap_or(h);
        // Until then it moves away from the barrier all the time.
        if sign * (value(x, catch) - barrier) <= 0.0 {
            let release = level_crossing(x, barrier, 0.0, catch);
            return (release, Some(Event::Release));
        }
        (catch, catches.as_slice().first().map(|_| Event::Reattach))
    }

    fn advance_contact(&mut self, (side, barrier): (Side, f64), whole: End, series: [&[f64; HIGHEST_ORDER + 1]; 3]) {
        let order = self.order;
        let [w, v, time] = series.map(|series| &series[..=order]);
        let remaining = self.options.duration - self.t;
        let (mut h, mut whole) = (self.length, whole);
        let last = whole.time >= remaining;
        if last {
            h = crossing_of(|u| value(time, u) - remaining, 0.0, h);
            whole = End {
                place: value(w, h),
                velocity: value(v, h),
                time: remaining,
                variation: variation(v, h),
            };
        }
        let turns = turning_points(v, h, whole);
        let (mut end, mut event) = (h, None);
        let (mut from, mut w_from) = (0.0, w[0]);
        let mut deepest = 0.0_f64;
        for (to, turning) in turns.as_slice().iter().map(|turn| (*turn, true)).chain([(h, false)]) {
            let w_to = if turning { value(w, to) } else { whole.place };
            if w_to <= 0.0 && to > 0.0 {
                let release = if w_from > 0.0 && w_to < 0.0 {
                    bracketed(w, 0.0, (from, w_from), (to, w_to))
                } else {
                    to
                };
                (end, event) = (release, Some(Event::Release));
                break;
            }
            deepest = deepest.max(w_to * w_to);
            if turning {
                self.turns.push(Turn {
                    t: self.t + value(time, to),
                    x: barrier + side.sign() * w_to * w_to,
                });
                if self.model.sticks() {
                    (end, event) = (to, Some(Event::Turn));
                    break;
                }
            }
            (from, w_from) = (to, w_to);
        }
        // The contact never pulls: gamma + mu v stays positive.
        if self.model.mu > 0.0 && v[0] - variation(v, end) < -self.model.gamma / self.model.mu {
            let mut excess = [0.0; HIGHEST_ORDER + 1];
            excess[..=order].copy_from_slice(v);
            excess[0] = (excess[0] + self.model.gamma / self.model.mu).max(0.0);
            if let Some(&detach) = sign_changes(&excess[..=order], end).as_slice().first()
                && detach < end
            {
                (end, event) = (detach, Some(Event::Detach));
            }
        }
        let energy = |u: f64| {
            let depth = value(w, u);
            let depth = depth * depth;
            self.model.swing_energy(barrier + side.sign() * depth, value(v, u)) + self.model.elastic_energy(depth)
        };
        if let Some(calm) = self.options.rest_energy
            && energy(end) <= calm
        {
            end = crossing_of(|u| energy(u) - calm, 0.0, end);
            event = Some(Event::Calm);
        }
        let start = self.t;
        self.t = if last && end == h {
            self.options.duration
        } else {
            start + if end == h { whole.time } else { value(time, end) }.max(0.0)
        };
        if self.options.keep_path {
            self.path
                .push_contact([start, self.t], (side, barrier), end, self.unit, [w, v, time]);
        }
        if let Some(impact) = self.impacts.last_mut() {
            impact.penetration = impact.penetration.max(deepest);
        }
        let (w_end, v_end) = if end == h {
            (whole.place, whole.velocity)
        } else {
            (value(w, end), value(v, end))
        };
        (self.place, self.velocity) = (w_end, v_end);
        if event != Some(Event::Release) {
            self.look(barrier + side.sign() * w_end * w_end);
        }
        self.adapt();
        match event {
            Some(Event::Turn) => {
                self.velocity = 0.0;
                self.turn();
            }
            Some(Event::Release) => {
                self.place = barrier;
                self.leave(side.sign() * v_end);
            }
            Some(Event::Detach) => {
                self.state = State::Detached(side);
                self.place = barrier + side.sign() * w_end * w_end;
                self.velocity = side.sign() * v_end;
                self.fly_in_state();
            }
            Some(Event::Calm) => self.calm(),
            _ => {}
        }
    }

    /// Contact begins, at this speed.
    fn touch(&mut self, side: Side, speed: f64) {
        enter(
            &mut self.impacts,
            (&self.model, &self.options),
            side,
            self.t,
            [0.0, speed],
        );
        self.press(side, 0.0, speed);
    }

    /// How far a motion that moves into the barrier from rest on it, and does so at least until `to`, may go before the
    /// contact force counts.
    fn onset(&self, side: Side, x: &[f64], v: &[f64], to: f64) -> f64 {
        let mut u = to;
        // Each time the part of the force shrinks by 4^4 or more.
        for _ in 0..MOST_IDLE {
            let (depth, speed) = (side.sign() * rise(x, u), side.sign() * value(v, u));
            if self.model.contact(depth, speed) * u * self.unit <= LIGHT * speed {
                break;
            }
            u *= 0.25;
        }
        u
    }

    /// Goes over to the equation of the contact after free flight from rest on the barrier, which has taken this time
    /// and ends at this depth and speed.
    fn lean(&mut self, side: Side, time: f64, [depth, speed]: [f64; 2]) {
        let force = self.model.contact(depth, speed);
        // d ~ t^k.
        let power = 1.5 * speed * time / depth;
        let (taken, back) = match power.is_finite() {
            true => {
                let taken = force * time / (power + 1.0);
                (taken, taken * time / (power + 2.0))
            }
            false => (0.0, 0.0),
        };
        self.press(side, (depth - back).max(0.0).sqrt(), speed - taken);
    }

    /// In contact at w with this speed inwards.
    fn press(&mut self, side: Side, w: f64, speed: f64) {
        self.state = State::Contact(side);
        let barrier = self.model.barrier(side).unwrap_or_default();
        self.place = w;
        self.velocity = speed;
        self.look(barrier + side.sign() * w * w);
        // The time of a Hertz contact in s: its greatest depth is that at which the barrier stores all the energy,
        // v^2/2 = (2/5) gamma d^(5/2), w = sqrt(d), dw/ds = v/2.
        let reached = (1.25 * speed * speed / self.model.gamma).powf(0.4).max(w * w);
        let fastest = (speed * speed + 2.0 * self.model.elastic_energy(w * w)).sqrt();
        // That of the other forces: dw/ds = v/2, dv/ds = w F. At a barrier near plumb there is next to none.
        let others = self.sine.abs() + self.model.alpha + self.model.beta.abs();
        let unit = (reached.sqrt() / fastest).min((2.0 / others).sqrt());
        self.unit = if unit.is_finite() && unit > 0.0 { unit } else { 1.0 };
    }

    /// Contact ends at this velocity.
    fn leave(&mut self, velocity: f64) {
        if let Some((side, barrier)) = self.side() {
            self.place = barrier;
            if let Some(impact) = self.impacts.last_mut() {
                impact.released(&self.model, self.t, (-side.sign() * velocity).max(0.0));
            }
        }
        self.velocity = velocity;
        self.state = State::Free;
        self.fly();
    }

    fn fly(&mut self) {
        self.look(self.place);
        self.fly_in_state();
    }

    fn fly_in_state(&mut self) {
        self.unit = 1.0 / self.velocity.abs().max(self.model.frequency_ratio).max(1.0);
    }

    fn look(&mut self, x: f64) {
        (self.sine, self.cosine) = x.sin_cos();
    }

    /// Keeps the unit near the length of the steps.
    fn adapt(&mut self) {
        let proposed = self.proposed;
        if !(0.125..=8.0).contains(&proposed) && proposed.is_finite() {
            let in_contact = matches!(self.state, State::Contact(_));
            let unit = self.unit * proposed.min(LONGEST_CONTACT_STEP);
            if unit > 0.0 && (unit <= LONGEST_STEP || in_contact && unit.is_finite()) {
                self.unit = unit;
            }
        }
    }

    /// The acceleration by all but friction at rest, now.
    fn force_at_rest(&self) -> f64 {
        let (t, x, _) = self.now();
        let contact = match self.side() {
            Some((side, _)) if matches!(self.state, State::Contact(_)) => {
                side.sign() * self.model.contact(self.place * self.place, 0.0)
            }
            _ => 0.0,
        };
        self.model.field(t, x) - contact
    }

    /// At rest under Coulomb friction: which way it goes on, if at all.
    fn turn(&mut self) {
        let force = self.force_at_rest();
        if force.abs() <= self.model.alpha * (1.0 + 4.0 * f64::EPSILON) {
            self.wait();
        } else {
            self.direction = force.signum();
        }
    }

    /// Held by friction until the excitation tears it loose, or to the end.
    fn wait(&mut self) {
        let (start, x, _) = self.now();
        let field = self.force_at_rest() - self.model.field(start, x) - x.sin();
        let (release, direction) = self.model.release(start, x, field).unwrap_or((f64::INFINITY, 0.0));
        let end = release.min(self.options.duration);
        if self.options.keep_path && end > start {
            self.path.push_rest([start, end], x);
        }
        if end > start {
            self.turns.push(Turn { t: end, x });
        }
        self.t = end;
        self.velocity = 0.0;
        if release < self.options.duration {
            self.direction = direction;
            self.released = true;
        } else {
            self.direction = 0.0;
            self.stop = Some(Stop::Duration);
        }
    }
}

/// How far x has risen since the start of the step: to more digits than x has.
fn rise(x: &[f64], u: f64) -> f64 {
    match x.split_first() {
        Some((_, rest)) => u * value(rest, u),
        None => 0.0,
    }
}

/// Where the velocity changes sign.
fn turning_points(v: &[f64], h: f64, end: End) -> Roots {
    // A motion at the edge of underflow has come to rest.
    if v[0].abs() > end.variation || end.variation < VANISHING {
        return Roots::new();
    }
    near_sign_changes(v, h, end.velocity)
}

/// The longest step at which the first term left out stays within what is allowed, by the radius of convergence that
/// the last coefficients tell: |v_n| ~ size / radius^n.
fn step_length(size: f64, allowed: f64, last: [f64; LAST], order: usize) -> f64 {
    let logarithm_of_size = logarithm(size);
    let mut inverse_radius = -1e3_f64;
    for (back, coefficient) in last.iter().enumerate() {
        let excess = logarithm(coefficient.abs()) - logarithm_of_size;
        inverse_radius = inverse_radius.max(excess * INVERSE[order - back]);
    }
    let left_out = (logarithm(allowed) - logarithm_of_size) * INVERSE[order + 1];
    power(left_out - inverse_radius)
}

/// The logarithm to base 2, to two decimals, which is enough for a step: from the bits of the number.
fn logarithm(number: f64) -> f64 {
    let bits = number.to_bits();
    let mantissa = f64::from_bits((bits & ((1 << 52) - 1)) | (1023 << 52)) - 1.0;
    let exponent = (bits >> 52) as f64 - 1023.0;
    exponent + mantissa * (1.343_5 - 0.343_5 * mantissa)
}

/// Two to this power, to a percent.
fn power(exponent: f64) -> f64 {
    // The integer below it, without a call.
    let toward_zero = exponent as i64;
    let whole = if (toward_zero as f64) > exponent {
        toward_zero - 1
    } else {
        toward_zero
    };
    let part = exponent - whole as f64;
    let scale = f64::from_bits(((whole + 1023).clamp(1, 2046) as u64) << 52);
    scale * (1.0 + part * (0.656_5 + 0.343_5 * part))
}

impl Model {
    /// When Coulomb friction lets go of a pendulum at rest at x, held since `t` against the constant force `field` and
    /// the excitation: the time and the direction; nothing where it holds for ever.
    ///
    /// |field + beta cos x sin(eta t)| = alpha, with the force on its way out.
    pub(super) fn release(&self, t: f64, x: f64, field: f64) -> Option<(f64, f64)> {
        let drive = self.beta * x.cos();
        if drive == 0.0 || self.frequency_ratio == 0.0 {
            return None;
        }
        let phase = self.frequency_ratio * t;
        let mut first: Option<(f64, f64)> = None;
        for direction in [1.0, -1.0] {
            let level = (direction * self.alpha - field) / drive;
            if level.abs() >= 1.0 {
                continue;
            }
            // On its way out: direction * drive * cos(phase) > 0.
            let angle = if direction * drive > 0.0 {
                level.asin()
            } else {
                PI - level.asin()
            };
            let turns = ((phase - angle) / TAU).floor();
            // The state may stand at the level already, to rounding: then it goes at once.
            let near = 1e-14 * phase.abs().max(1.0);
            let mut candidate = angle + TAU * turns;
            if candidate < phase - near {
                candidate += TAU;
            }
            let time = (candidate / self.frequency_ratio).max(t);
            if first.is_none_or(|(earlier, _)| time < earlier) {
                first = Some((time, direction));
            }
        }
        first
    }
}

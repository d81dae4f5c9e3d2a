//! Contact: its beginning and end, and the events in a step of the regularised equation.

use super::{Loaded, Runner, StepEvent, turning_points};
use crate::impact::hertz;
use crate::impact::model::{Model, Side};
use crate::impact::polynomial::{bracketed, crossing_of, sign_changes, value, variation};
use crate::impact::simulation::Regime;
use crate::impact::simulation::{TurningPoint, begin_contact};
use crate::impact::taylor::course::StepEvents;
use crate::impact::taylor::series::{HIGHEST_ORDER, StepEndState};

/// One step of the regularised equation: w, v and t as polynomials.
struct ContactStep<'a> {
    side: Side,
    barrier: f64,
    w: &'a [f64],
    v: &'a [f64],
    time: &'a [f64],
}

impl ContactStep<'_> {
    fn depth(&self, u: f64) -> f64 {
        let w = value(self.w, u);
        w * w
    }

    fn x(&self, depth: f64) -> f64 {
        self.barrier + self.side.sign() * depth
    }
}

/// The part of a step that takes a given time: its length, and the values at its end.
pub(super) fn cut(
    [place, velocity, time]: [&[f64]; 3],
    remaining: f64,
    (length, whole): (f64, StepEndState),
) -> (f64, StepEndState) {
    let h = crossing_of(|u| value(time, u) - remaining, 0.0, length);
    let end = StepEndState {
        place: value(place, h),
        velocity: value(velocity, h),
        time: remaining,
        variation: variation(velocity, h),
        ..whole
    };
    (h, end)
}

impl Runner {
    /// Takes a step in contact in the simple case, if no other event ends it.
    pub(super) fn press_on(
        &mut self,
        (side, barrier): (Side, f64),
        end: StepEndState,
        course: StepEvents,
        load: impl FnOnce() -> Loaded,
    ) -> bool {
        let x = |w: f64| barrier + side.sign() * (w * w);
        let (at, w, velocity, time) = match course.crossing {
            None => (self.length, end.place, end.velocity, end.time),
            Some((point, _)) => (point.at, 0.0, point.velocity, point.time),
        };
        let lowest = self.velocity - end.variation;
        if self.model.would_pull(lowest) || self.settings.duration - self.t <= time {
            return false;
        }
        let (sine, cosine) = match course.crossing {
            None => (side.sign() * end.sine, end.cosine),
            Some(_) => self.angle_at(side),
        };
        // The energy stored in the barrier comes on top.
        if self.is_at_rest_energy(velocity, cosine) {
            return false;
        }
        let mut deepest = w * w;
        if let Some(turn) = course.turn {
            deepest = deepest.max(turn.place * turn.place);
            self.turns.push(TurningPoint { t: self.t + turn.time, x: x(turn.place) });
        }
        if let Some(impact) = self.impacts.last_mut() {
            impact.penetration = impact.penetration.max(deepest);
        }
        let start = self.t;
        self.t = start + time.max(0.0);
        if self.settings.keep_path {
            let series = load();
            let series = series.each_ref().map(|series| &series[..=self.order]);
            self.path.push_series([start, self.t], (self.regime, Some(barrier)), at, series);
        }
        (self.place, self.velocity, self.sine, self.cosine) = (w, velocity, sine, cosine);
        match course.crossing {
            None => self.adapt(),
            Some(_) => self.leave_contact(side.sign() * velocity),
        }
        true
    }

    /// Takes a step in contact up to the event that ends it, and continues from there.
    pub(super) fn advance_contact(
        &mut self,
        (side, barrier): (Side, f64),
        whole: StepEndState,
        series: [&[f64; HIGHEST_ORDER + 1]; 3],
    ) {
        let [w, v, time] = series.map(|series| &series[..=self.order]);
        let step = ContactStep { side, barrier, w, v, time };
        let remaining = self.settings.duration - self.t;
        // Beyond the release, where w < 0, the time would fall again.
        let releases = sign_changes(w, self.length);
        let (until, most) = match releases.as_slice().first() {
            Some(release) => (*release, value(time, *release)),
            None => (self.length, whole.time),
        };
        let last = most >= remaining;
        let (h, whole) = match last {
            true => cut([w, v, time], remaining, (until, whole)),
            false => (self.length, whole),
        };
        let (mut end, mut event, deepest) = self.turns_and_release(&step, h, whole);
        if let Some(detach) = self.detachment(v, end) {
            (end, event) = (detach, Some(StepEvent::Detach));
        }
        let energy = |u: f64| {
            let depth = step.depth(u);
            self.model.swing_energy(step.x(depth), value(v, u)) + self.model.elastic_energy(depth)
        };
        if let Some(rest_energy) = self.settings.rest_energy
            && energy(end) <= rest_energy
        {
            end = crossing_of(|u| energy(u) - rest_energy, 0.0, end);
            event = Some(StepEvent::RestEnergy);
        }
        let start = self.t;
        self.t = if last && end == h {
            self.settings.duration
        } else {
            start + if end == h { whole.time } else { value(time, end) }.max(0.0)
        };
        if self.settings.keep_path {
            self.path.push_series([start, self.t], (self.regime, Some(barrier)), end, [w, v, time]);
        }
        if let Some(impact) = self.impacts.last_mut() {
            impact.penetration = impact.penetration.max(deepest);
        }
        (self.place, self.velocity) =
            if end == h { (whole.place, whole.velocity) } else { (value(w, end), value(v, end)) };
        self.go_on(&step, event);
    }

    /// Records the turning points of a step and finds the event that ends it: its position, its
    /// kind, and the greatest depth up to there.
    fn turns_and_release(
        &mut self,
        step: &ContactStep,
        h: f64,
        whole: StepEndState,
    ) -> (f64, Option<StepEvent>, f64) {
        let turns = turning_points(step.v, h, whole);
        let (mut from, mut w_from) = (0.0, step.w[0]);
        let mut deepest = 0.0_f64;
        for (to, turning) in turns.as_slice().iter().map(|turn| (*turn, true)).chain([(h, false)]) {
            let w_to = if turning { value(step.w, to) } else { whole.place };
            if w_to <= 0.0 && to > 0.0 {
                let release = if w_from > 0.0 && w_to < 0.0 {
                    bracketed(step.w, 0.0, (from, w_from), (to, w_to))
                } else {
                    to
                };
                return (release, Some(StepEvent::Release), deepest);
            }
            deepest = deepest.max(w_to * w_to);
            if turning {
                self.turns.push(TurningPoint {
                    t: self.t + value(step.time, to),
                    x: step.x(w_to * w_to),
                });
                if self.model.sticks() {
                    return (to, Some(StepEvent::Turn), deepest);
                }
            }
            (from, w_from) = (to, w_to);
        }
        (h, None, deepest)
    }

    /// The point in a step that ends at `end` at which the barrier would begin to pull: gamma + mu
    /// v stays positive.
    fn detachment(&self, v: &[f64], end: f64) -> Option<f64> {
        let Model { gamma, mu, .. } = self.model;
        if mu <= 0.0 || v[0] - variation(v, end) >= -gamma / mu {
            return None;
        }
        let mut excess = [0.0; HIGHEST_ORDER + 1];
        let excess = &mut excess[..v.len()];
        excess.copy_from_slice(v);
        excess[0] = (excess[0] + gamma / mu).max(0.0);
        let detach = sign_changes(excess, end).as_slice().first().copied();
        detach.filter(|detach| *detach < end)
    }

    /// Continues from the end of a step in contact, which has this w and velocity.
    fn go_on(&mut self, step: &ContactStep, event: Option<StepEvent>) {
        let (w, velocity) = (self.place, self.velocity);
        if event != Some(StepEvent::Release) {
            self.set_angle(step.x(w * w));
        }
        self.adapt();
        match event {
            Some(StepEvent::Turn) => {
                self.velocity = 0.0;
                self.turn();
            }
            Some(StepEvent::Release) => {
                self.place = step.barrier;
                self.leave_contact(step.side.sign() * velocity);
            }
            Some(StepEvent::Detach) => {
                self.regime = Regime::Detached(step.side);
                self.base = 0.0;
                self.place = step.x(w * w);
                self.velocity = step.side.sign() * velocity;
                self.set_flight_unit();
            }
            Some(StepEvent::RestEnergy) => self.end_at_rest_energy(),
            _ => {}
        }
    }

    /// Begins a contact at this speed.
    pub(super) fn touch(&mut self, side: Side, speed: f64) {
        begin_contact(&mut self.impacts, (&self.model, &self.settings), side, self.t, [0.0, speed]);
        self.enter_contact(side, 0.0, speed);
    }

    /// Changes to the equation of the contact after free flight from rest on the barrier, which has
    /// taken this time and ends at this depth and speed.
    pub(super) fn begin_contact_from_rest(
        &mut self,
        side: Side,
        time: f64,
        [depth, speed]: [f64; 2],
    ) {
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
        self.enter_contact(side, (depth - back).max(0.0).sqrt(), speed - taken);
    }

    /// Sets the state in contact at w with this speed inwards.
    pub(super) fn enter_contact(&mut self, side: Side, w: f64, speed: f64) {
        self.regime = Regime::Contact(side);
        let barrier = self.model.barrier(side).unwrap_or_default();
        self.place = w;
        self.base = side.sign() * barrier;
        self.velocity = speed;
        self.set_angle(barrier + side.sign() * w * w);
        // The time of a Hertz contact in s: its greatest depth is that at which the barrier stores
        // all the energy, v^2/2 = (2/5) gamma d^(5/2), w = sqrt(d), dw/ds = v/2.
        let reached = hertz::greatest_depth(self.model.gamma, speed).max(w * w);
        let fastest = (speed * speed + 2.0 * self.model.elastic_energy(w * w)).sqrt();
        self.hertz = [reached.sqrt(), fastest];
        // The time scale of the other forces: dw/ds = v/2, dv/ds = w F. At a barrier near the
        // bottom they are almost zero.
        let others = self.sine.abs() + self.model.alpha + self.model.beta.abs();
        let unit = (reached.sqrt() / fastest).min((2.0 / others).sqrt());
        self.unit = if unit.is_finite() && unit > 0.0 { unit } else { 1.0 };
    }

    /// Ends the contact at this velocity.
    pub(super) fn leave_contact(&mut self, velocity: f64) {
        if let Some((side, barrier)) = self.side() {
            self.place = barrier;
            if let Some(impact) = self.impacts.last_mut() {
                impact.released(&self.model, self.t, (-side.sign() * velocity).max(0.0));
            }
        }
        self.velocity = velocity;
        self.regime = Regime::Free;
        self.fly();
    }
}

//! Free flight and the events that end a step of it: a touch of a barrier, the onset of a contact
//! from rest on it, a turning point.

use super::contact::cut;
use super::{LIGHT, Loaded, MOST_IDLE, Runner, SLOWEST_TOUCH, StepEvent, turning_points};
use crate::impact::model::Side;
use crate::impact::polynomial::{bracketed, crossing_of, level_crossing, sign_changes, value};
use crate::impact::simulation::Regime;
use crate::impact::simulation::{TurningPoint, begin_contact};
use crate::impact::taylor::angle::sine_and_cosine;
use crate::impact::taylor::course::StepEvents;
use crate::impact::taylor::series::{HIGHEST_ORDER, StepEndState, TIME_TERMS};

impl Runner {
    /// Takes a step of free flight in the simple case, if no other event ends it.
    pub(super) fn fly_on(
        &mut self,
        end: StepEndState,
        course: StepEvents,
        load: impl FnOnce() -> Loaded,
    ) -> bool {
        if self.settings.duration - self.t <= end.time {
            return false;
        }
        let (x, velocity, touched) = match course.crossing {
            None => (end.place, end.velocity, None),
            Some((point, rises)) => {
                let side = if rises { Side::Right } else { Side::Left };
                if side.sign() * point.velocity <= SLOWEST_TOUCH {
                    return false;
                }
                let barrier = self.model.barrier(side).unwrap_or_default();
                (barrier, point.velocity, Some((side, point)))
            }
        };
        let (sine, cosine) = match touched {
            None => (end.sine, end.cosine),
            Some((side, _)) => self.angle_at(side),
        };
        if self.regime != Regime::Free || self.is_at_rest_energy(velocity, cosine) {
            return false;
        }
        if let Some(turn) = course.turn {
            self.turns.push(TurningPoint { t: self.t + turn.time, x: turn.place });
        }
        let start = self.t;
        let (at, time) =
            touched.map_or((self.length, end.time), |(_, point)| (point.at, point.time));
        self.t = start + time;
        if self.settings.keep_path {
            let [x, v, time] = load();
            let series = [&x[..=self.order], &v[..=self.order], &time[..TIME_TERMS]];
            self.path.push_series([start, self.t], (self.regime, None), at, series);
        }
        (self.place, self.velocity, self.sine, self.cosine) = (x, velocity, sine, cosine);
        match touched {
            None => self.adapt(),
            Some((side, _)) => self.touch(side, side.sign() * velocity),
        }
        true
    }

    /// Takes a step of free flight up to the event that ends it, and continues from there.
    pub(super) fn advance_flight(
        &mut self,
        whole: StepEndState,
        series: [&[f64; HIGHEST_ORDER + 1]; 3],
    ) {
        let [x, v, time] = series;
        let (x, v, time) = (&x[..=self.order], &v[..=self.order], &time[..TIME_TERMS]);
        let remaining = self.settings.duration - self.t;
        let last = whole.time >= remaining;
        let (h, whole) = match last {
            true => cut([x, v, time], remaining, (self.length, whole)),
            false => (self.length, whole),
        };
        let (mut end, mut event) = match self.regime {
            Regime::Detached(side) => self.detached_event(side, x, v, h),
            _ => self.flight_event([x, v, time], h, whole),
        };
        let energy = |u: f64| self.model.energy(value(x, u), value(v, u));
        let (mut x_end, mut v_end) =
            if end == h { (whole.place, whole.velocity) } else { (value(x, end), value(v, end)) };
        if let Some(StepEvent::Touch(side)) = event {
            x_end = self.model.barrier(side).unwrap_or(x_end);
        }
        let (mut sine, mut cosine) = self.angle(x_end);
        if let Some(rest_energy) = self.settings.rest_energy
            && self.is_at_rest_energy(v_end, cosine)
            && matches!(self.regime, Regime::Free)
        {
            end = crossing_of(|u| energy(u) - rest_energy, 0.0, end);
            event = Some(StepEvent::RestEnergy);
            (x_end, v_end) = (value(x, end), value(v, end));
            (sine, cosine) = sine_and_cosine(x_end);
        }
        let start = self.t;
        let elapsed = if end == h { whole.time } else { value(time, end) };
        self.t = if last && end == h { self.settings.duration } else { start + elapsed };
        if self.settings.keep_path {
            let state = match event {
                Some(StepEvent::Onset(side)) => Regime::Contact(side),
                _ => self.regime,
            };
            self.path.push_series([start, self.t], (state, None), end, [x, v, time]);
        }
        (self.place, self.velocity, self.sine, self.cosine) = (x_end, v_end, sine, cosine);
        self.adapt();
        match event {
            None => {}
            Some(StepEvent::Turn) => {
                self.velocity = 0.0;
                self.turn();
            }
            Some(StepEvent::Touch(side)) if v_end.abs() > SLOWEST_TOUCH => {
                self.touch(side, side.sign() * v_end)
            }
            Some(StepEvent::Onset(side)) => {
                let depth = side.sign() * rise(x, end);
                begin_contact(
                    &mut self.impacts,
                    (&self.model, &self.settings),
                    side,
                    start,
                    [0.0, 0.0],
                );
                self.begin_contact_from_rest(side, elapsed, [depth, side.sign() * v_end]);
            }
            Some(StepEvent::Touch(side) | StepEvent::Settle(side)) => {
                (self.place, self.velocity) = (self.model.barrier(side).unwrap_or(x_end), 0.0);
                self.fly();
            }
            Some(StepEvent::Release) => self.leave_contact(v_end),
            Some(StepEvent::Reattach) => {
                if let Regime::Detached(side) = self.regime {
                    let barrier = self.model.barrier(side).unwrap_or_default();
                    self.enter_contact(
                        side,
                        (side.sign() * (self.place - barrier)).max(0.0).sqrt(),
                        side.sign() * v_end,
                    );
                }
            }
            Some(StepEvent::RestEnergy) => self.end_at_rest_energy(),
            Some(StepEvent::Detach) => {}
        }
    }

    /// The event that ends a free flight before `h`, and its time. Turning points on the way are
    /// recorded.
    fn flight_event(
        &mut self,
        [x, v, time]: [&[f64]; 3],
        h: f64,
        end: StepEndState,
    ) -> (f64, Option<StepEvent>) {
        let turns = turning_points(v, h, end);
        let (mut from, mut x_from) = (0.0, x[0]);
        let ends = turns.as_slice().iter().map(|turn| (*turn, true)).chain([(h, false)]);
        for (to, turning) in ends {
            let x_to = if turning { value(x, to) } else { end.place };
            for side in [Side::Right, Side::Left] {
                let sign = side.sign();
                // At rest on the barrier the direction of motion is given by the change of x, not
                // by x - x_r.
                if from == 0.0 && v[0] == 0.0 && self.model.barrier(side) == Some(x[0]) {
                    if sign * rise(x, to) > 0.0 {
                        return (self.onset(side, [x, v, time], to), Some(StepEvent::Onset(side)));
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
                        return (touch, Some(StepEvent::Touch(side)));
                    }
                    // Beyond the barrier by more than rounding but without speed: the pendulum
                    // turned on the barrier and is pushed in.
                    if sign * (x_to - barrier) > 8.0 * f64::EPSILON * barrier.abs().max(1.0) {
                        return (touch, Some(StepEvent::Settle(side)));
                    }
                }
            }
            if turning {
                self.turns.push(TurningPoint { t: self.t + value(time, to), x: x_to });
                if self.model.sticks() {
                    return (to, Some(StepEvent::Turn));
                }
            }
            (from, x_from) = (to, x_to);
        }
        (h, None)
    }

    /// The event that ends the flight away from a barrier that is still recovering: the pendulum
    /// has passed its rest position, or is no faster than the barrier.
    fn detached_event(
        &mut self,
        side: Side,
        x: &[f64],
        v: &[f64],
        h: f64,
    ) -> (f64, Option<StepEvent>) {
        let barrier = self.model.barrier(side).unwrap_or_default();
        let sign = side.sign();
        let mut excess = [0.0; HIGHEST_ORDER + 1];
        for (entry, coefficient) in excess.iter_mut().zip(v) {
            *entry = sign * coefficient;
        }
        // The excess begins at zero or below, whatever the rounding.
        excess[0] = (excess[0] + self.model.gamma / self.model.mu).min(0.0);
        let catches = sign_changes(&excess[..=self.order], h);
        let catch = catches.as_slice().first().copied().unwrap_or(h);
        // Until then the pendulum always moves away from the barrier.
        if sign * (value(x, catch) - barrier) <= 0.0 {
            let release = level_crossing(x, barrier, 0.0, catch);
            return (release, Some(StepEvent::Release));
        }
        (catch, catches.as_slice().first().map(|_| StepEvent::Reattach))
    }

    /// The step length up to which the contact force is negligible, for a motion that moves into
    /// the barrier from rest on it at least until `to`.
    fn onset(&self, side: Side, [x, v, time]: [&[f64]; 3], to: f64) -> f64 {
        let mut u = to;
        // Each iteration reduces the share of the force by 4^4 or more.
        for _ in 0..MOST_IDLE {
            let (depth, speed) = (side.sign() * rise(x, u), side.sign() * value(v, u));
            if self.model.contact(depth, speed) * value(time, u) <= LIGHT * speed {
                break;
            }
            u *= 0.25;
        }
        u
    }

    pub(super) fn fly(&mut self) {
        self.base = 0.0;
        self.set_angle(self.place);
        self.set_flight_unit();
    }

    pub(super) fn set_flight_unit(&mut self) {
        self.unit = 1.0 / self.velocity.abs().max(self.model.frequency_ratio).max(1.0);
    }
}

/// The change of x since the start of the step, with more digits than x has.
fn rise(x: &[f64], u: f64) -> f64 {
    match x.split_first() {
        Some((_, rest)) => u * value(rest, u),
        None => 0.0,
    }
}

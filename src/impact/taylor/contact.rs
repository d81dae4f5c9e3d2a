//! Contact: its begin and its end, and what happens in a step of the regularised equation.

use super::{Event, Runner, turning_points};
use crate::impact::model::Side;
use crate::impact::polynomial::{bracketed, crossing_of, sign_changes, value, variation};
use crate::impact::simulation::State;
use crate::impact::simulation::{Turn, enter};
use crate::impact::taylor::series::{End, HIGHEST_ORDER};

impl Runner {
    /// Takes a whole step in contact if its ends show that nothing happens in it and nobody wants to see it.
    pub(super) fn press_on(&mut self, (side, barrier): (Side, f64), end: End) -> bool {
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

    /// Takes a step in contact up to what ends it, and goes on from there.
    pub(super) fn advance_contact(
        &mut self,
        (side, barrier): (Side, f64),
        whole: End,
        series: [&[f64; HIGHEST_ORDER + 1]; 3],
    ) {
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
    pub(super) fn touch(&mut self, side: Side, speed: f64) {
        enter(
            &mut self.impacts,
            (&self.model, &self.options),
            side,
            self.t,
            [0.0, speed],
        );
        self.press(side, 0.0, speed);
    }

    /// Goes over to the equation of the contact after free flight from rest on the barrier, which has taken this time
    /// and ends at this depth and speed.
    pub(super) fn lean(&mut self, side: Side, time: f64, [depth, speed]: [f64; 2]) {
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
    pub(super) fn press(&mut self, side: Side, w: f64, speed: f64) {
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
    pub(super) fn leave(&mut self, velocity: f64) {
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
}

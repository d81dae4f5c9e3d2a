//! The motion between impacts in closed form, in numbers.
//!
//! ```text
//! x(t) = w(t) + z(t),   w = U cos(omega t) + V sin(omega t)     the steady wave
//! z'' + c z' + k z = P,   (z, z') -> Phi(tau) (z, z') + P (r, r')
//! Phi = ((C + beta S, S), (-k S, C - beta S)),   beta = c/2
//! C = exp(-beta tau) cos(omega_d tau),   S = exp(-beta tau) sin(omega_d tau)/omega_d
//! ```
//!
//! with `cosh` and `sinh` where the motion is overdamped, `S = tau exp(-beta tau)` where it is
//! critically damped, and `r` the motion from rest under a unit force.

use super::equation::{BiasedHarmonic, ImpactNumbers, WallNumbers};
use crate::numeric::ode::root::{BisectionStop, bisect};

/// A linear driven motion without walls, in closed form.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ClosedFlow {
    damping: f64,
    stiffness: f64,
    pub(super) frequency: f64,
    load: BiasedHarmonic<f64>,
    /// U and V of the steady wave.
    pub(super) wave: [f64; 2],
}

/// The free motion over a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Propagator {
    /// C.
    pub(super) cosine: f64,
    /// S.
    pub(super) sine: f64,
    /// The matrix Phi by rows.
    pub(super) matrix: [[f64; 2]; 2],
    /// Position and velocity from rest under a unit force.
    pub(super) from_rest: [f64; 2],
}

impl ClosedFlow {
    /// The motion under this load; `None` if an undamped motion is driven at its own frequency, where
    /// no steady wave exists.
    pub(super) fn new(
        [damping, stiffness, frequency]: [f64; 3],
        load: &BiasedHarmonic<f64>,
    ) -> Option<Self> {
        let (dynamic, turn) = (stiffness - frequency * frequency, damping * frequency);
        let size = dynamic.hypot(turn);
        // Rounding of k - omega^2 is of the order of 1e-16 omega^2.
        if size <= 1e-14 * frequency * frequency {
            return None;
        }
        let square = size * size;
        let wave = [
            (load.cosine * dynamic - load.sine * turn) / square,
            (load.sine * dynamic + load.cosine * turn) / square,
        ];
        Some(Self { damping, stiffness, frequency, load: *load, wave })
    }

    /// The amplitude of the steady wave.
    pub(super) fn amplitude(&self) -> f64 {
        self.wave[0].hypot(self.wave[1])
    }

    /// Position and velocity of the steady wave.
    pub(super) fn steady_wave(&self, time: f64) -> [f64; 2] {
        let (sine, cosine) = (self.frequency * time).sin_cos();
        let [u, v] = self.wave;
        [u * cosine + v * sine, self.frequency * (v * cosine - u * sine)]
    }

    /// The acceleration at a time in a state.
    pub(super) fn acceleration(&self, time: f64, [position, velocity]: [f64; 2]) -> f64 {
        self.load.value(self.frequency * time) - self.damping * velocity - self.stiffness * position
    }

    /// The free motion over a time.
    pub(super) fn propagator(&self, time: f64) -> Propagator {
        let (c, k) = (self.damping, self.stiffness);
        let [cosine, sine] = damped_waves(c, k, time);
        let beta = 0.5 * c;
        Propagator {
            cosine,
            sine,
            matrix: [[cosine + beta * sine, sine], [-k * sine, cosine - beta * sine]],
            from_rest: [displacement_from_rest(c, k, time, [cosine, sine]), sine],
        }
    }

    /// The state a time after a start.
    pub(super) fn state(&self, start: f64, state: [f64; 2], after: f64) -> [f64; 2] {
        self.state_by(&self.propagator(after), start, state, after)
    }

    fn state_by(&self, by: &Propagator, start: f64, state: [f64; 2], after: f64) -> [f64; 2] {
        let (from, to) = (self.steady_wave(start), self.steady_wave(start + after));
        let free = by.advance([state[0] - from[0], state[1] - from[1]], self.load.constant);
        [to[0] + free[0], to[1] + free[1]]
    }

    /// The times from one sample to the next with which no oscillation is passed over.
    fn step(&self) -> f64 {
        const SAMPLES_OF_PERIOD: f64 = 40.0;
        let fastest = self.frequency.max(self.stiffness.abs().sqrt());
        std::f64::consts::TAU / (SAMPLES_OF_PERIOD * fastest)
    }

    /// Samples the gap on a leg that begins at zero gap with the velocity `velocity` and ends after
    /// `length`: the first time after the start at which it is negative, before the end; `None` if
    /// it stays positive. The load of the flow is that of the gap.
    pub(super) fn negative_gap(&self, start: f64, velocity: f64, length: f64) -> Option<f64> {
        let count = (length / self.step()).ceil().max(8.0);
        // A leg so long that its samples are no longer counted fails as not followed.
        if count.is_nan() || count >= 1e7 {
            return Some(f64::NAN);
        }
        let step = length / count;
        let by = self.propagator(step);
        let (turn_sine, turn_cosine) = (self.frequency * step).sin_cos();
        let from = self.steady_wave(start);
        let mut wave = [from[0], from[1] / self.frequency];
        let mut free = [-from[0], velocity - from[1]];
        let mut before = [0.0, velocity];
        let gap = |after: f64| self.state(start, [0.0, velocity], after);
        for number in 1..count as u64 {
            free = by.advance(free, self.load.constant);
            wave = [
                wave[0] * turn_cosine + wave[1] * turn_sine,
                wave[1] * turn_cosine - wave[0] * turn_sine,
            ];
            let now = [wave[0] + free[0], self.frequency * wave[1] + free[1]];
            let (left, right) = ((number - 1) as f64 * step, number as f64 * step);
            if now[0] < 0.0 {
                let [_, first] =
                    bisect(|t| gap(t)[0] > 0.0, left, right, BisectionStop::Halvings(40));
                return Some(first);
            }
            // A minimum between two samples, unless the gap is larger than the way to it: the speed
            // falls to zero there.
            let way = -2.0 * step * before[1];
            if before[1] < 0.0 && now[1] > 0.0 && before[0] <= way {
                let [least, _] =
                    bisect(|t| gap(t)[1] < 0.0, left, right, BisectionStop::Halvings(50));
                if gap(least)[0] < 0.0 {
                    let [_, first] =
                        bisect(|t| gap(t)[0] > 0.0, left, least, BisectionStop::Halvings(40));
                    return Some(first);
                }
            }
            before = now;
        }
        None
    }
}

impl Propagator {
    /// The free state at the end, under a constant force.
    pub(super) fn advance(&self, [position, velocity]: [f64; 2], force: f64) -> [f64; 2] {
        let [first, second] = self.matrix;
        [
            first[0] * position + first[1] * velocity + force * self.from_rest[0],
            second[0] * position + second[1] * velocity + force * self.from_rest[1],
        ]
    }
}

/// C and S of the head of this file.
fn damped_waves(damping: f64, stiffness: f64, time: f64) -> [f64; 2] {
    /// Below this square of the phase the series is exact to rounding, and the quotient cancels.
    const SMALL: f64 = 1e-2;
    let beta = 0.5 * damping;
    let square = stiffness - beta * beta;
    let phase_square = square * time * time;
    let decay = (-beta * time).exp();
    if phase_square.abs() < SMALL {
        let z = phase_square;
        let cosine = 1.0 - z / 2.0 * (1.0 - z / 12.0 * (1.0 - z / 30.0 * (1.0 - z / 56.0)));
        let sine = 1.0 - z / 6.0 * (1.0 - z / 20.0 * (1.0 - z / 42.0 * (1.0 - z / 72.0)));
        return [decay * cosine, decay * time * sine];
    }
    if square > 0.0 {
        let rate = square.sqrt();
        let (sine, cosine) = (rate * time).sin_cos();
        return [decay * cosine, decay * sine / rate];
    }
    // The product of a vanishing and a growing exponential would lose both.
    let rate = (-square).sqrt();
    let [slow, fast] = [(rate - beta) * time, (-rate - beta) * time].map(f64::exp);
    [0.5 * (slow + fast), 0.5 * (slow - fast) / rate]
}

/// The motion from rest under a unit force.
fn displacement_from_rest(
    damping: f64,
    stiffness: f64,
    time: f64,
    [cosine, sine]: [f64; 2],
) -> f64 {
    let (c, k) = (damping, stiffness);
    if c.abs() * time + k.abs() * time * time < 1.0 {
        // The series of y'' + c y' + k y = 1.
        let (mut before, mut now, mut sum) = (0.0, 0.5 * time * time, 0.0);
        for order in 2_u32..40 {
            sum += now;
            let order = f64::from(order);
            let scale = time / (order + 1.0);
            let next = -(c * now + k * before * time / order) * scale;
            (before, now) = (now, next);
        }
        return sum;
    }
    if k.abs() * time * time > 1e-6 {
        return (1.0 - cosine - 0.5 * c * sine) / k;
    }
    // Nearly without stiffness: c r + k (its integral) = time - S.
    let first = (time - sine) / c;
    (time - sine - k * (0.5 * time * time - first) / c) / c
}

/// An impact that a motion comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Contact {
    /// The time since the start.
    pub(super) after: f64,
    /// The index of the wall.
    pub(super) wall: usize,
    /// The state at the impact, before it.
    pub(super) state: [f64; 2],
}

/// The motion between walls.
pub(super) struct WalledFlow<'a> {
    pub(super) flow: ClosedFlow,
    pub(super) walls: &'a [WallNumbers],
}

impl<'a> WalledFlow<'a> {
    /// The motion of a question; `None` at an undamped resonance.
    pub(super) fn new(numbers: &'a ImpactNumbers) -> Option<Self> {
        let own = [numbers.damping, numbers.stiffness, numbers.frequency];
        Some(Self { flow: ClosedFlow::new(own, &numbers.load)?, walls: &numbers.walls })
    }

    /// The gap of a wall and its rate.
    pub(super) fn gap(&self, wall: usize, time: f64, [position, velocity]: [f64; 2]) -> [f64; 2] {
        let WallNumbers { side, offset, .. } = &self.walls[wall];
        let phase = self.flow.frequency * time;
        [
            side * position + offset.value(phase),
            side * velocity + self.flow.frequency * offset.slope(phase),
        ]
    }

    /// The first impact after a start, within a time; the wall that the motion may stand on at the
    /// start does not count there. `None` if there is none.
    pub(super) fn first_contact(
        &self,
        start: f64,
        state: [f64; 2],
        within: f64,
    ) -> Option<Contact> {
        let step = self.flow.step();
        let by = self.flow.propagator(step);
        let mut now = state;
        let mut time = 0.0;
        let mut gaps: Vec<[f64; 2]> =
            (0..self.walls.len()).map(|wall| self.gap(wall, start, state)).collect();
        while time < within {
            let from = now;
            now = self.flow.state_by(&by, start + time, from, step);
            let state_after = |after: f64| self.flow.state(start + time, from, after);
            let mut first: Option<Contact> = None;
            for (wall, before) in gaps.iter_mut().enumerate() {
                let gap = |after: f64| self.gap(wall, start + time + after, state_after(after));
                let at_end = self.gap(wall, start + time + step, now);
                if let Some(after) = zero_within(*before, at_end, step, time == 0.0, gap)
                    && first.is_none_or(|first| after < first.after)
                {
                    first = Some(Contact { after, wall, state: state_after(after) });
                }
                *before = at_end;
            }
            if let Some(contact) = first {
                return Some(Contact { after: time + contact.after, ..contact });
            }
            time += step;
        }
        None
    }
}

/// The first time within a step at which the gap falls through zero.
fn zero_within(
    before: [f64; 2],
    after: [f64; 2],
    step: f64,
    at_start: bool,
    gap: impl Fn(f64) -> [f64; 2],
) -> Option<f64> {
    const HALVINGS: BisectionStop = BisectionStop::Halvings(60);
    let falls = |from: f64, to: f64| {
        let [_, first] = bisect(|t| gap(t)[0] > 0.0, from, to, HALVINGS);
        Some(first)
    };
    // From the wall the gap first grows: its largest value lies before the fall.
    let begins_on_wall =
        at_start && before[0] <= 1e-12 * (step * before[1].abs()).max(before[0].abs());
    if after[0] < 0.0 {
        let from = match begins_on_wall {
            true => bisect(|t| gap(t)[1] > 0.0, 0.0, step, HALVINGS)[0],
            false => 0.0,
        };
        return falls(from, step);
    }
    if before[1] < 0.0 && after[1] > 0.0 {
        let [least, _] = bisect(|t| gap(t)[1] < 0.0, 0.0, step, HALVINGS);
        if gap(least)[0] < 0.0 {
            return falls(0.0, least);
        }
    }
    None
}

//! Random driven pairs of oscillators: every stable motion is in the response.
//!
//! ```text
//! x'' + c x' + x + a x^2 + b x^3 + g (x - y) + h (x - y)^3 = F cos(w t)
//! y'' + d y' + k y + e y^3 + p x^2 + g (y - x) + h (y - x)^3 = 0
//! ```
//!
//! The equations are written as text for the program, and as functions for this test, which finds
//! motions by itself: stable ones by following random starts for some hundred periods by the classical
//! Runge-Kutta method with equal steps, and by Newton's method with differences from as many random
//! states. Each stable one, or an image of it (a drive period later, or mirrored), must lie on a branch
//! at that value of the parameter: Newton's method from the branch leads to it.
//!
//! `cargo test` runs a few pairs. By hand, some seconds each:
//!
//! ```text
//! LINDSTEDT_RANDOM_COUNT=300 LINDSTEDT_RANDOM_SEED=1000000 cargo test --test library random_pairs -- --nocapture
//! ```

use std::f64::consts::TAU;

use lindstedt::response::{Branch, ResponseRequest, SteadyMotion, respond};
use nalgebra::{Matrix4, Vector4};

use crate::random::Random;

/// Positions, then velocities.
type State = Vector4<f64>;

/// A pair of which w or F varies.
#[derive(Clone, Debug)]
struct Pair {
    /// c and d.
    damping: [f64; 2],
    /// a, b, k, e and p.
    forces: [f64; 5],
    /// g and h.
    coupling: [f64; 2],
    /// F and w; that which varies is not used.
    drive: [f64; 2],
    parameter: &'static str,
    range: [f64; 2],
    periods: usize,
}

impl Pair {
    /// The pair of a seed.
    fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let between = |random: &mut Random, low: f64, high: f64| {
            ((low + (high - low) * random.unit()) * 1e3).round() / 1e3
        };
        let damping = [0, 1].map(|_| between(&mut random, 0.03, 0.3));
        let square = if random.percent(30.0) { between(&mut random, -0.5, 0.5) } else { 0.0 };
        let other = if random.percent(30.0) { between(&mut random, -0.5, 0.5) } else { 0.0 };
        let cube = between(&mut random, 0.1, 1.5);
        // A stiffness of its own, an equal one, or one near an internal resonance.
        let stiffness = random.choose(&[1.0, 4.0, 9.0]) * between(&mut random, 0.9, 1.3);
        let forces = [square, cube, stiffness, between(&mut random, 0.0, 1.5), other];
        let coupling = [between(&mut random, -0.2, 0.5), between(&mut random, 0.0, 0.5)];
        let drive = [between(&mut random, 0.1, 1.2), between(&mut random, 0.5, 2.5)];
        let parameter = random.choose(&["w", "w", "F"]);
        let range = match parameter {
            "w" => {
                let low = between(&mut random, 0.5, 1.6);
                [low, low + between(&mut random, 0.3, 1.0)]
            }
            _ => [0.05, between(&mut random, 0.3, 1.5)],
        };
        let periods = random.choose(&[1, 1, 1, 2]);
        Self { damping, forces, coupling, drive, parameter, range, periods }
    }

    /// The equations as text.
    fn text(&self) -> String {
        let Self { damping: [c, d], forces: [a, b, k, e, p], coupling: [g, h], .. } = self;
        let [force, frequency] = self.drive.map(|value| value.to_string());
        let (force, frequency) = match self.parameter {
            "w" => (force, "w".to_owned()),
            _ => ("F".to_owned(), frequency),
        };
        format!(
            "x'' + {c}*x' + x + ({a})*x^2 + {b}*x^3 + ({g})*(x - y) + {h}*(x - y)^3 = {force}*cos({frequency}*t); \
             y'' + {d}*y' + {k}*y + {e}*y^3 + ({p})*x^2 + ({g})*(y - x) + {h}*(y - x)^3 = 0"
        )
    }

    /// F and w at a value of the parameter.
    fn drive_at(&self, value: f64) -> [f64; 2] {
        match self.parameter {
            "w" => [self.drive[0], value],
            _ => [value, self.drive[1]],
        }
    }

    fn rates(&self, [force, w]: [f64; 2], t: f64, state: &State) -> State {
        let Self { damping: [c, d], forces: [a, b, k, e, p], coupling: [g, h], .. } = self;
        let [x, y, v, u] = state.as_slice() else { return State::zeros() };
        let apart = x - y;
        let between = apart * (g + h * apart * apart);
        let first = force * (w * t).cos() - c * v - x * (1.0 + x * (a + b * x)) - between;
        State::new(*v, *u, first, between - d * u - y * (k + e * y * y) - p * x * x)
    }

    /// State after this many drive periods from the state at t = 0.
    fn after(&self, drive: [f64; 2], state: State, periods: f64) -> State {
        self.in_steps(drive, state, periods, 160.0)
    }

    /// State after this many drive periods, in so many steps for each.
    fn in_steps(&self, drive: [f64; 2], mut state: State, periods: f64, steps: f64) -> State {
        let count = (steps * periods).round() as usize;
        let h = TAU / drive[1] * periods / count as f64;
        for step in 0..count {
            let t = h * step as f64;
            let one = self.rates(drive, t, &state);
            let two = self.rates(drive, t + 0.5 * h, &(state + one * (0.5 * h)));
            let three = self.rates(drive, t + 0.5 * h, &(state + two * (0.5 * h)));
            let four = self.rates(drive, t + h, &(state + three * h));
            state += (one + (two + three) * 2.0 + four) * (h / 6.0);
        }
        state
    }

    /// The periodic motion near a start by Newton's method with differences, and the size of its
    /// largest multiplier.
    fn closed(&self, drive: [f64; 2], mut state: State) -> Option<(State, f64)> {
        let map = |state: State| self.after(drive, state, self.periods as f64);
        for _ in 0..25 {
            let image = map(state);
            let h = 1e-6 * (1.0 + state.amax());
            let column = |i: usize| {
                let mut moved = state;
                moved[i] += h;
                (map(moved) - image) / h
            };
            let monodromy = Matrix4::from_columns(&[0, 1, 2, 3].map(column));
            let step = (Matrix4::identity() - monodromy).lu().solve(&(image - state))?;
            state += step;
            if !state.iter().all(|value| value.abs() < 1e3) {
                return None;
            }
            if step.amax() < 1e-9 * (1.0 + state.amax()) {
                let largest = monodromy.complex_eigenvalues().map(|value| value.norm()).max();
                return Some((state, largest));
            }
        }
        None
    }

    fn is_one(one: &State, other: &State) -> bool {
        (one - other).amax() < 1e-5 * (1.0 + one.amax())
    }

    /// The stable motions that random starts come to, and those that Newton's method finds.
    fn stable(&self, drive: [f64; 2], random: &mut Random) -> Vec<State> {
        const STARTS: usize = 24;
        const REACH: f64 = 4.0;
        let mut found: Vec<State> = Vec::new();
        for start in 0..2 * STARTS {
            let begin = State::from_fn(|_, _| REACH * (2.0 * random.unit() - 1.0));
            let guess = match start < STARTS {
                true => {
                    let least = self.damping[0].min(self.damping[1]);
                    let decay = (30.0 / least * drive[1] / TAU).min(300.0);
                    let periods = self.periods as f64 * (decay / self.periods as f64).ceil();
                    self.after(drive, begin, periods)
                }
                false => begin,
            };
            let Some((state, largest)) = self.closed(drive, guess) else { continue };
            // A motion of many fast waves is none that these steps can follow.
            let finer = self.in_steps(drive, state, self.periods as f64, 320.0);
            if (finer - state).amax() > 1e-3 * (1.0 + state.amax()) {
                continue;
            }
            if largest < 0.995 && !found.iter().any(|known| Self::is_one(known, &state)) {
                found.push(state);
            }
        }
        found
    }

    /// Whether a motion lies on one of the branches.
    fn is_listed(&self, branches: &[Branch], value: f64, start: State) -> bool {
        let drive = self.drive_at(value);
        let mut images = vec![start];
        for period in 1..self.periods {
            images.push(self.after(drive, start, period as f64));
        }
        // Mirrored, half a drive period later: -x(t + T/2) is a motion if this is one.
        let [a, _, _, _, p] = self.forces;
        if a == 0.0 && p == 0.0 {
            let mirrored: Vec<State> =
                images.iter().map(|state| -self.after(drive, *state, 0.5)).collect();
            images.extend(mirrored);
        }
        let begin = |point: &SteadyMotion| {
            let [x, y] = &point.coordinates[..] else { panic!("{point:?}") };
            State::new(x.start, y.start, x.rate, y.rate)
        };
        let near = |guess: State| {
            self.closed(drive, guess)
                .is_some_and(|(found, _)| images.iter().any(|image| Self::is_one(image, &found)))
        };
        branches.iter().flat_map(|branch| branch.points.windows(2)).any(|pair| {
            let [one, other] = pair else { return false };
            let part = (value - one.parameter) / (other.parameter - one.parameter);
            let [one, other] = [one, other].map(begin);
            (-0.05..=1.05).contains(&part)
                && [one + (other - one) * part, one, other].into_iter().any(near)
        })
    }

    /// The stable motions that are missing from the response, as values of the parameter with starts;
    /// and how many there are.
    fn missing(&self, branches: &[Branch], seed: u64) -> (Vec<(f64, State)>, usize) {
        let mut random = Random::new(seed);
        let (mut missing, mut all) = (Vec::new(), 0);
        for part in [0.17, 0.55, 0.86] {
            let value = self.range[0] + part * (self.range[1] - self.range[0]);
            let stable = self.stable(self.drive_at(value), &mut random);
            all += stable.len();
            let is_missing = |start: &State| !self.is_listed(branches, value, *start);
            missing.extend(stable.into_iter().filter(is_missing).map(|start| (value, start)));
        }
        (missing, all)
    }
}

/// The number of stable motions of a pair, all of which are listed; or those that are missing.
fn judged(seed: u64) -> Result<usize, String> {
    let pair = Pair::new(seed);
    let Pair { parameter, range: [low, high], periods, .. } = pair;
    let text = pair.text();
    let named = format!("{seed}: \"{text}\" --vary {parameter}={low}:{high} --periods {periods}");
    let request = ResponseRequest::new(&text, parameter, [low, high], "").expect(&text);
    let response = respond(&ResponseRequest { periods, ..request });
    let response = response.map_err(|error| format!("{named}: {error}"))?;
    let (missing, all) = pair.missing(&response.branches, seed);
    match missing.is_empty() {
        true => Ok(all),
        false => Err(format!("{named}: {} of {all} missing: {missing:?}", missing.len())),
    }
}

fn setting(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

#[test]
fn every_stable_motion_of_a_random_pair_is_listed() {
    let count = setting("LINDSTEDT_RANDOM_COUNT").unwrap_or(3);
    let first = setting("LINDSTEDT_RANDOM_SEED").unwrap_or(1);
    let (mut motions, mut wrong) = (0, Vec::new());
    for seed in first..first + count {
        match judged(seed) {
            Ok(all) => motions += all,
            Err(message) => {
                println!("{message}");
                wrong.push(message);
            }
        }
    }
    println!("{count} pairs, {motions} stable motions, {} pairs with missing ones", wrong.len());
    assert!(wrong.is_empty() && motions > 0, "{wrong:#?}");
}

//! Random driven equations, and some at which motions were once missing: every stable motion is in
//! the response.
//!
//! The equation is written as text for the program, and as a function for this test, which finds
//! stable motions by itself: from random starts it follows some hundred periods by the classical
//! Runge-Kutta method with equal steps, and where a motion has become periodic Newton's method with
//! differences closes it. Each of them, or an image of it (a drive period later, or mirrored), must
//! lie on a branch at that value of the parameter: Newton's method from the branch leads to it.
//!
//! `cargo test` runs a few equations. By hand, some seconds each:
//!
//! ```text
//! LINDSTEDT_RANDOM_COUNT=300 LINDSTEDT_RANDOM_SEED=1000000 cargo test --test library random_responses -- --nocapture
//! ```

use std::f64::consts::TAU;

use lindstedt::response::{Branch, ResponseRequest, respond};

use crate::random::Random;

/// Seeds at which a stable motion was once missing.
const FOUND: [u64; 14] = [
    2000059, 2000184, 3000006, 3000054, 5100064, 82000086, 82000148, 92000179, 94000270, 95000167,
    95000214, 95000356, 97000007, 99000184,
];

/// Seeds at which this test was wrong: its steps were too coarse for a short touch of a stop.
const TOUCHING: [u64; 2] = [81000054, 93000036];

/// Number of steps of a drive period.
const STEPS: usize = 120;

/// The restoring force and the drive of an equation `x'' + c x' + f = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// `k1 x + k2 x^2 + k3 x^3 - f0 - F cos(w t)`
    Polynomial,
    /// `sin x - F cos(w t)`
    Pendulum,
    /// `(1 + F cos(w t)) x + k3 x^3`
    Parametric,
    /// `x + k3 max(x - 1/2, 0)^(3/2) - F cos(w t)`
    Stop,
}

/// The numbers of an equation.
#[derive(Clone, Copy, Debug)]
struct Numbers {
    /// c.
    damping: f64,
    /// k1, k2 and k3.
    stiffness: [f64; 3],
    /// f0.
    offset: f64,
    /// F and w.
    drive: f64,
    frequency: f64,
}

/// An equation of which one letter varies.
#[derive(Clone, Debug)]
struct Case {
    kind: Kind,
    /// The numbers; that of the letter that varies is not used.
    numbers: Numbers,
    parameter: &'static str,
    range: [f64; 2],
    periods: usize,
}

impl Case {
    /// The equation of a seed.
    fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let round = |value: f64| format!("{value:.3}").parse::<f64>().unwrap_or(value);
        let kind = random.choose(&[
            Kind::Polynomial,
            Kind::Polynomial,
            Kind::Polynomial,
            Kind::Pendulum,
            Kind::Parametric,
            Kind::Stop,
        ]);
        let linear = match kind {
            Kind::Polynomial => random.choose(&[1.0, 1.0, 1.0, 0.0, -1.0]),
            _ => 1.0,
        };
        let square = match kind {
            Kind::Polynomial if random.percent(40.0) => round(random.between(0.1, 1.0)),
            _ => 0.0,
        };
        let cube = match kind {
            Kind::Stop => round(random.between(1.0, 300.0)),
            Kind::Pendulum => 0.0,
            _ => round(random.between(0.2, 2.0)),
        };
        let damping = round(random.between(0.02, 0.4));
        let drive = match kind {
            Kind::Parametric => round(random.between(0.1, 0.8)),
            _ => round(random.between(0.05, 1.5)),
        };
        let frequency = round(random.between(0.4, 3.0));
        let numbers =
            Numbers { damping, stiffness: [linear, square, cube], offset: 0.0, drive, frequency };
        let parameter = random.choose(&["w", "w", "c", "F"]);
        let range = match parameter {
            "w" => {
                let low = round(random.between(0.4, 1.6));
                [low, round(low * random.between(1.3, 2.5))]
            }
            "c" => [0.02, 0.4],
            _ => [0.05, round(random.between(0.3, 1.5))],
        };
        let periods = random.choose(&[1, 1, 1, 2, 3]);
        let periods = if kind == Kind::Parametric { 2 } else { periods };
        Self { kind, numbers, parameter, range, periods }
    }

    /// Cases at which motions were once missing: a large motion that no simulation from rest comes
    /// to, by damping and by the drive; a tongue narrower than a step; a branch of motions of two
    /// drive periods that goes through two crossings back onto itself.
    fn known() -> Vec<Self> {
        let duffing = Numbers {
            damping: 0.047,
            stiffness: [1.0, 0.0, 1.0],
            offset: 0.0,
            drive: 0.3,
            frequency: 1.5,
        };
        let case = |kind: Kind,
                    numbers: Numbers,
                    varied: (&'static str, [f64; 2]),
                    periods: usize| {
            Self { kind, numbers, parameter: varied.0, range: varied.1, periods }
        };
        let stop = Numbers { stiffness: [1.0, 0.0, 50.0], drive: 0.2, frequency: 1.6, ..duffing };
        let tongue = Numbers { damping: 0.005, drive: 0.011, frequency: 2.0, ..duffing };
        let tilted = Numbers {
            damping: 0.04,
            stiffness: [1.0, 0.0, 0.5],
            offset: 0.4,
            drive: 1.5,
            ..duffing
        };
        vec![
            case(Kind::Polynomial, duffing, ("c", [0.02, 0.4]), 1),
            case(Kind::Polynomial, duffing, ("F", [0.1, 0.3]), 1),
            case(Kind::Pendulum, Numbers { frequency: 0.7, ..duffing }, ("c", [0.01, 0.4]), 1),
            case(Kind::Stop, stop, ("c", [0.01, 0.1]), 1),
            case(Kind::Parametric, tongue, ("w", [1.9, 2.1]), 2),
            case(Kind::Polynomial, tilted, ("w", [2.0, 3.4]), 2),
        ]
    }

    /// The equation as text.
    fn text(&self) -> String {
        let of = |name: &str, value: f64| match name == self.parameter {
            true => name.to_owned(),
            false => value.to_string(),
        };
        let Numbers { damping, stiffness: [k1, k2, k3], offset, drive, frequency } = self.numbers;
        let (c, amplitude, w) = (of("c", damping), of("F", drive), of("w", frequency));
        let wave = format!("{amplitude}*cos({w}*t)");
        let force = match self.kind {
            Kind::Polynomial => format!("{k1}*x + {k2}*x^2 + {k3}*x^3 - {offset} - {wave}"),
            Kind::Pendulum => format!("sin(x) - {wave}"),
            Kind::Parametric => format!("(1 + {wave})*x + {k3}*x^3"),
            Kind::Stop => format!("x + {k3}*max(x - 0.5, 0)^1.5 - {wave}"),
        };
        format!("x'' + {c}*x' + {force} = 0")
    }

    /// The numbers at a value of the parameter.
    fn at(&self, value: f64) -> Numbers {
        match self.parameter {
            "w" => Numbers { frequency: value, ..self.numbers },
            "c" => Numbers { damping: value, ..self.numbers },
            _ => Numbers { drive: value, ..self.numbers },
        }
    }

    fn acceleration(&self, numbers: &Numbers, t: f64, x: f64, v: f64) -> f64 {
        let [k1, k2, k3] = numbers.stiffness;
        let wave = numbers.drive * (numbers.frequency * t).cos();
        let force = match self.kind {
            Kind::Polynomial => x * (k1 + x * (k2 + x * k3)) - numbers.offset - wave,
            Kind::Pendulum => x.sin() - wave,
            Kind::Parametric => (1.0 + wave) * x + k3 * x * x * x,
            Kind::Stop => x + k3 * (x - 0.5).max(0.0).powf(1.5) - wave,
        };
        -numbers.damping * v - force
    }

    /// State after this many drive periods from the state at t = 0, in so many steps for each.
    fn after(
        &self,
        numbers: &Numbers,
        [mut x, mut v]: [f64; 2],
        periods: f64,
        steps: usize,
    ) -> [f64; 2] {
        let count = (steps as f64 * periods).round() as usize;
        let h = TAU / numbers.frequency * periods / count as f64;
        for step in 0..count {
            let t = h * step as f64;
            let rate = |t: f64, x: f64, v: f64| [v, self.acceleration(numbers, t, x, v)];
            let one = rate(t, x, v);
            let two = rate(t + 0.5 * h, x + 0.5 * h * one[0], v + 0.5 * h * one[1]);
            let three = rate(t + 0.5 * h, x + 0.5 * h * two[0], v + 0.5 * h * two[1]);
            let four = rate(t + h, x + h * three[0], v + h * three[1]);
            x += h / 6.0 * (one[0] + 2.0 * two[0] + 2.0 * three[0] + four[0]);
            v += h / 6.0 * (one[1] + 2.0 * two[1] + 2.0 * three[1] + four[1]);
        }
        [x, v]
    }

    /// The periodic motion near a start by Newton's method with differences, and the size of its
    /// larger multiplier, in so many steps for each drive period.
    fn closed(&self, numbers: &Numbers, start: [f64; 2], steps: usize) -> Option<([f64; 2], f64)> {
        let map = |y: [f64; 2]| self.after(numbers, y, self.periods as f64, steps);
        let mut y = start;
        for _ in 0..30 {
            let image = map(y);
            let h = 1e-6 * (1.0 + y[0].abs() + y[1].abs());
            let [bx, bv] = [map([y[0] + h, y[1]]), map([y[0], y[1] + h])];
            let m = [
                [(bx[0] - image[0]) / h, (bv[0] - image[0]) / h],
                [(bx[1] - image[1]) / h, (bv[1] - image[1]) / h],
            ];
            let (p, q) = (image[0] - y[0], image[1] - y[1]);
            let (a, b, c, d) = (1.0 - m[0][0], -m[0][1], -m[1][0], 1.0 - m[1][1]);
            let det = a * d - b * c;
            let step = [(p * d - b * q) / det, (a * q - c * p) / det];
            y = [y[0] + step[0], y[1] + step[1]];
            if !(y[0].is_finite() && y[1].is_finite()) {
                return None;
            }
            if step[0].abs() + step[1].abs() < 1e-9 * (1.0 + y[0].abs() + y[1].abs()) {
                let (trace, det) = (m[0][0] + m[1][1], m[0][0] * m[1][1] - m[0][1] * m[1][0]);
                let root = trace * trace / 4.0 - det;
                let largest = match root > 0.0 {
                    true => (trace / 2.0).abs() + root.sqrt(),
                    false => det.sqrt(),
                };
                return Some((y, largest));
            }
        }
        None
    }

    fn is_one(&self, one: [f64; 2], other: [f64; 2]) -> bool {
        let scale = 1.0 + one[0].abs() + one[1].abs();
        let apart = match self.kind {
            Kind::Pendulum => {
                let turns = ((one[0] - other[0]) / TAU).round();
                one[0] - other[0] - TAU * turns
            }
            _ => one[0] - other[0],
        };
        apart.abs() + (one[1] - other[1]).abs() < 1e-5 * scale
    }

    /// Drive periods after which a motion has settled, as a rule.
    fn settling_periods(&self, numbers: &Numbers) -> f64 {
        let decay = 40.0 / numbers.damping * numbers.frequency / TAU;
        self.periods as f64 * (decay.min(400.0) / self.periods as f64).ceil()
    }

    /// The stable motions that random starts come to.
    fn stable(&self, value: f64, random: &mut Random) -> Vec<[f64; 2]> {
        const STARTS: usize = 40;
        const REACH: f64 = 4.0;
        let numbers = self.at(value);
        let mut found: Vec<[f64; 2]> = Vec::new();
        for _ in 0..STARTS {
            let y = [0, 1].map(|_| REACH * (2.0 * random.unit() - 1.0));
            let end = self.after(&numbers, y, self.settling_periods(&numbers), STEPS);
            if end[0].is_nan() || end[0].abs() > 1e3 {
                continue;
            }
            let again = self.after(&numbers, end, self.periods as f64, STEPS);
            if (again[0] - end[0]).abs() + (again[1] - end[1]).abs() > 1e-2 {
                continue;
            }
            let Some((start, largest)) = self.closed(&numbers, end, STEPS) else { continue };
            if largest > 0.995 || start[0].abs() > 50.0 {
                continue;
            }
            if !found.iter().any(|known| self.is_one(*known, start)) {
                found.push(start);
            }
        }
        found
    }

    /// Whether a motion lies on one of the branches. With equal steps a short touch of a stop, or a large motion, may
    /// be so coarse that Newton's method does not settle, or that there is no such motion: where it leads from
    /// no branch to the motion, that to which ten times as many steps lead from there decides, and if it
    /// is not periodic, whether the motion is one with them at all.
    fn is_listed(&self, branches: &[Branch], value: f64, start: [f64; 2]) -> bool {
        const FINER: usize = 10 * STEPS;
        let numbers = self.at(value);
        let refined = || {
            let settled = self.after(&numbers, start, self.settling_periods(&numbers), FINER);
            Some(self.closed(&numbers, settled, FINER)?.0)
        };
        let comes_back = || {
            let [x, v] = self.after(&numbers, start, self.periods as f64, FINER);
            (x - start[0]).abs() + (v - start[1]).abs() < 1e-2 * (start[0].abs() + start[1].abs())
        };
        self.is_listed_in(branches, value, start, STEPS)
            || match refined() {
                Some(start) => self.is_listed_in(branches, value, start, FINER),
                None => !comes_back(),
            }
    }

    /// Whether a motion lies on one of the branches, with so many steps for each drive period.
    fn is_listed_in(&self, branches: &[Branch], value: f64, start: [f64; 2], steps: usize) -> bool {
        let numbers = self.at(value);
        let mut images = vec![start];
        for period in 1..self.periods {
            images.push(self.after(&numbers, start, period as f64, steps));
        }
        // Mirrored, half a drive period later: -x(t + T/2) is a motion if this is one.
        let half = |y: [f64; 2]| {
            let odd = self.kind == Kind::Pendulum
                || self.kind == Kind::Polynomial && numbers.stiffness[1] == 0.0;
            odd.then(|| self.after(&numbers, y, 0.5, steps).map(|value| -value))
        };
        let mut mirrored: Vec<[f64; 2]> = images.iter().filter_map(|y| half(*y)).collect();
        if self.kind == Kind::Parametric {
            mirrored.extend(images.iter().map(|y| y.map(|value| -value)));
        }
        images.extend(mirrored);
        let near = |guess: [f64; 2]| {
            self.closed(&numbers, guess, steps)
                .is_some_and(|(found, _)| images.iter().any(|image| self.is_one(*image, found)))
        };
        let mut guesses = Vec::new();
        for branch in branches {
            for pair in branch.points.windows(2) {
                let [one, other] = pair else { continue };
                let way = other.parameter - one.parameter;
                let part = (value - one.parameter) / way;
                if (-0.05..=1.05).contains(&part) {
                    guesses.push(
                        [0, 1].map(|i| one.start[i] + part * (other.start[i] - one.start[i])),
                    );
                    guesses.push(one.start);
                    guesses.push(other.start);
                }
            }
        }
        guesses.into_iter().any(near)
    }

    /// The stable motions that are missing from the response, as values of the parameter with starts;
    /// and how many there are.
    fn missing(&self, branches: &[Branch], seed: u64) -> (Vec<(f64, [f64; 2])>, usize) {
        let mut random = Random::new(seed);
        let (mut missing, mut all) = (Vec::new(), 0);
        for part in [0.13, 0.5, 0.83] {
            let value = self.range[0] + part * (self.range[1] - self.range[0]);
            let stable = self.stable(value, &mut random);
            all += stable.len();
            let is_missing = |start: &[f64; 2]| !self.is_listed(branches, value, *start);
            missing.extend(stable.into_iter().filter(is_missing).map(|start| (value, start)));
        }
        (missing, all)
    }
}

/// Compares the response of a case with its stable motions: a line about it, or its fault as an error.
fn judged(case: &Case, seed: u64) -> Result<String, String> {
    let Case { parameter, range: [low, high], periods, .. } = case;
    let text = case.text();
    let named = format!("{seed}: {text} --vary {parameter}={low}:{high} --periods {periods}");
    let mut question = ResponseRequest::new(&text, parameter, case.range, "")
        .map_err(|error| format!("{named}: {error}"))?;
    question.periods = *periods;
    let response = respond(&question).map_err(|error| format!("{named}: {error}"))?;
    let (missing, all) = case.missing(&response.branches, seed);
    let line = format!("{named}: {} branches, {all} stable motions", response.branches.len());
    match missing.is_empty() {
        true => Ok(line),
        false => Err(format!("{line}, without {missing:?}")),
    }
}

fn setting(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

#[test]
fn every_stable_motion_of_a_random_equation_is_listed() {
    let first = setting("LINDSTEDT_RANDOM_SEED").unwrap_or(1000000);
    let count = setting("LINDSTEDT_RANDOM_COUNT");
    let random = (first..first + count.unwrap_or(4)).map(|seed| (Case::new(seed), seed));
    let known = Case::known().into_iter().map(|case| (case, 0));
    let found = FOUND.into_iter().chain(TOUCHING).map(|seed| (Case::new(seed), seed));
    let before = known.chain(found).filter(|_| count.is_none());
    let mut wrong = Vec::new();
    for (case, seed) in random.chain(before) {
        match judged(&case, seed) {
            Ok(line) => println!("{line}"),
            Err(line) => {
                println!("{line}");
                wrong.push(line);
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

//! Records made from known laws by another integrator than that of the fit, Runge-Kutta, and from forces written out by hand.

use std::f64::consts::{PI, TAU};

use lindstedt_fit::fit::laws::{Loss, Spring};
use lindstedt_fit::fit::motion::Quantity;
use lindstedt_fit::fit::record::Record;
use lindstedt_fit::numeric::ode::{Event, IntegrationOptions, State, integrate};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A record with the law that it was made from.
pub struct Synthetic {
    pub record: Record,
    pub spring: Spring,
    pub loss: Loss,
    /// The parameters by their names.
    pub truth: Vec<(&'static str, f64)>,
    pub words: String,
}

fn uniform(generator: &mut ChaCha8Rng, from: f64, to: f64) -> f64 {
    from + (to - from) * generator.random::<f64>()
}

/// A normal deviate by the method of Box and Muller.
pub fn normal(generator: &mut ChaCha8Rng) -> f64 {
    let radius = (-2.0 * (1.0 - generator.random::<f64>()).ln()).sqrt();
    radius * (TAU * generator.random::<f64>()).cos()
}

/// The acceleration of a law for one sign of the velocity.
pub fn acceleration(
    spring: Spring,
    loss: Loss,
    truth: &[(&str, f64)],
    x: f64,
    v: f64,
    sign: f64,
) -> f64 {
    let number =
        |name: &str| truth.iter().find(|(own, _)| *own == name).map_or(0.0, |(_, value)| *value);
    let w = number("w");
    let force = match spring {
        Spring::Linear => w * w * x,
        Spring::Duffing => w * w * x + number("beta") * x.powi(3),
        Spring::Quadratic => w * w * x + number("b") * x * x,
        Spring::Pendulum => w * w * x.sin(),
        Spring::Power => number("k") * x.abs().powf(number("n")).copysign(x),
    };
    let speed = (sign * v).max(0.0);
    let dry = number("alpha") * w * w + number("d");
    let viscous = 2.0 * number("zeta") * w + number("c");
    let power = match loss {
        Loss::Power => number("r") * speed.powf(number("p")),
        _ => 0.0,
    };
    -force - viscous * v - sign * (dry + number("q") * speed * speed + power)
}

/// The motion at increasing times from the first one on, by Runge-Kutta from reversal to reversal, and from zero to zero of a power-law
/// spring.
pub fn motion(
    spring: Spring,
    loss: Loss,
    truth: &[(&str, f64)],
    start: [f64; 2],
    times: &[f64],
) -> Vec<f64> {
    let size = start[0].abs().max(1e-3 * start[1].abs());
    let options = IntegrationOptions {
        absolute_tolerance: 1e-12 * size,
        ..IntegrationOptions::with_tolerance(1e-12)
    };
    let last = times[times.len() - 1];
    let mut state = State { t: times[0], x: start[0], v: start[1] };
    let mut sign = match state.v == 0.0 {
        true => -state.x.signum(),
        false => state.v.signum(),
    };
    let mut values = vec![];
    while values.len() < times.len() {
        let own = |x: f64, v: f64, sign: f64| acceleration(spring, loss, truth, x, v, sign);
        let mut events = vec![Event::stop(|_, _, v| v)];
        events[0] = if sign > 0.0 {
            Event::stop(|_, _, v| v).falling()
        } else {
            Event::stop(|_, _, v| v).rising()
        };
        if spring == Spring::Power {
            let crossing = Event::stop(|_, x, _| x);
            events.push(if sign > 0.0 { crossing.rising() } else { crossing.falling() });
        }
        let path =
            integrate(|_, x, v| own(x, v, sign), state, last, &events, &options).expect("a motion");
        let from = values.len();
        let found = times[from..].iter().map_while(|time| path.phase_point_at(*time));
        values.extend(found.map(|(x, _)| x));
        state = path.end();
        if path.occurrences().last().is_none_or(|last| last.event == 1) {
            assert!(values.len() == times.len() || state.t < last, "{:?}", path.stop_reason());
            state.x = if values.len() < times.len() { 0.0 } else { state.x };
            continue;
        }
        state.v = 0.0;
        sign = if own(state.x, 0.0, 1.0) > 0.0 { 1.0 } else { -1.0 };
        if own(state.x, 0.0, sign) * sign <= 0.0 {
            // Friction holds it.
            values.resize(times.len(), state.x);
        }
    }
    values
}

/// The length of a record: the ranges of its cycles and of the samples of each.
#[derive(Clone, Copy)]
pub struct Length {
    pub cycles: [f64; 2],
    pub samples: [f64; 2],
}

/// The records of the long run.
pub const LONG: Length = Length { cycles: [15.0, 40.0], samples: [20.0, 50.0] };

/// Records that are fitted sooner.
pub const SHORT: Length = Length { cycles: [9.0, 14.0], samples: [20.0, 30.0] };

/// The record of this seed. Springs and losses take turns; all else is drawn.
pub fn synthetic(seed: u64, length: Length) -> Synthetic {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let generator = &mut generator;
    let spring = Spring::ALL[(seed % 5) as usize];
    let loss = Loss::ALL[((seed / 5) % 6) as usize];
    let size = match spring {
        Spring::Pendulum => uniform(generator, 0.6, 1.5),
        _ => 10.0_f64.powf(uniform(generator, -2.0, 1.0)),
    };
    let w = TAU * uniform(generator, 0.5, 5.0);
    let mut truth: Vec<(&'static str, f64)> = vec![];
    let sign = if generator.random::<bool>() { 1.0 } else { -1.0 };
    match spring {
        Spring::Linear | Spring::Pendulum => truth.push(("w", w)),
        Spring::Duffing => {
            let share = sign * uniform(generator, 0.1, 0.4);
            truth.extend([("w", w), ("beta", share * (w / size).powi(2))]);
        }
        Spring::Quadratic => {
            let share = sign * uniform(generator, 0.1, 0.3);
            truth.extend([("w", w), ("b", share * w * w / size)]);
        }
        Spring::Power => {
            let n = if sign > 0.0 {
                uniform(generator, 1.3, 3.0)
            } else {
                uniform(generator, 0.5, 0.8)
            };
            truth.extend([("k", w * w * size.powf(1.0 - n)), ("n", n)]);
        }
    }
    let cycles = uniform(generator, length.cycles[0], length.cycles[1]);
    let rest = uniform(generator, 0.15, 0.5);
    let has_frequency = spring != Spring::Power;
    let viscous = |zeta: f64| if has_frequency { ("zeta", zeta) } else { ("c", 2.0 * zeta * w) };
    let dry = |alpha: f64| if has_frequency { ("alpha", alpha) } else { ("d", alpha * w * w) };
    match loss {
        Loss::None => {}
        Loss::Viscous => truth.push(viscous((1.0 / rest).ln() / (TAU * cycles))),
        Loss::Coulomb => truth.push(dry(size * (1.0 - rest) / (4.0 * cycles))),
        Loss::Quadratic => truth.push(("q", (1.0 / rest - 1.0) / (8.0 / 3.0 * size * cycles))),
        Loss::Power => {
            let p = [[0.3, 0.6], [1.4, 1.7], [2.4, 3.0]][generator.random_range(0..3)];
            let p = uniform(generator, p[0], p[1]);
            // dA/dn = -2 r A^p w^(p - 2) I for the cycles n, I = int_0^pi sin^(p + 1).
            const STEPS: u32 = 2000;
            let place = |step: u32| (f64::from(step) + 0.5) * PI / f64::from(STEPS);
            let integral: f64 = (0..STEPS).map(|step| place(step).sin().powf(p + 1.0)).sum::<f64>()
                * PI
                / f64::from(STEPS);
            let change = size.powf(1.0 - p) * (rest.powf(1.0 - p) - 1.0) / (p - 1.0);
            truth.extend([("r", change / (2.0 * cycles * w.powf(p - 2.0) * integral)), ("p", p)]);
        }
        Loss::ViscousAndCoulomb => {
            let share = uniform(generator, 1.0, 3.0);
            let zeta = ((1.0 + 1.0 / share) / (rest + 1.0 / share)).ln() / (TAU * cycles);
            truth.extend([viscous(zeta), dry(TAU * zeta * size / (4.0 * share))]);
        }
    }
    let count = (cycles * uniform(generator, length.samples[0], length.samples[1])) as usize;
    let step = cycles * TAU / w / count as f64;
    let is_uneven = generator.random::<bool>();
    let first = uniform(generator, -10.0, 10.0);
    let jitter = if is_uneven { 0.4 } else { 0.0 };
    let times: Vec<f64> = (0..count)
        .map(|index| first + step * (index as f64 + jitter * uniform(generator, -1.0, 1.0)))
        .collect();
    let noise = size * uniform(generator, 0.002, 0.01);
    let quantum = noise * uniform(generator, 0.2, 1.5);
    let is_quantised = generator.random::<bool>();
    let offset = size * uniform(generator, -0.5, 0.5);
    let drift = if generator.random::<bool>() { size * uniform(generator, -0.1, 0.1) } else { 0.0 };
    let phase = uniform(generator, 0.0, TAU);
    let start = [size * phase.cos(), size * w * phase.sin()];
    let motion = motion(spring, loss, &truth, start, &times);
    let values = motion.iter().zip(&times).map(|(x, time)| {
        let value =
            x + offset + drift * (time - first) / (step * count as f64) + noise * normal(generator);
        if is_quantised { (value / quantum).round() * quantum } else { value }
    });
    let words = format!(
        "seed {seed}: {} {} cycles {cycles:.0} samples {count} rest {rest:.2} noise {:.4} quantised {is_quantised} uneven {is_uneven}",
        spring.name(),
        loss.name(),
        noise / size
    );
    let record = Record {
        values: values.collect(),
        times,
        quantity: Quantity::Displacement,
        is_angle: spring == Spring::Pendulum,
    };
    Synthetic { record, spring, loss, truth, words }
}

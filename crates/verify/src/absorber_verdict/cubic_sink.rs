//! A light mass on a cubic spring: its periodic motions beside a main mass that moves as `C cos t`, by
//! Runge-Kutta with all harmonics, and both masses set free.
//!
//! In units in which k is 1, the relative motion from `z(0) = a`, `z'(0) = 0` repeats mirrored after half a
//! period under `z'' + lambda z' + z^3 = p cos t + q sin t`; the two unknowns p and q follow by Newton's
//! method, and `C = hypot(p, q)` as a function of a has its extremes at the folds.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix2, Vector2};

use super::{AbsorberCurve, AbsorberCurveKind, AbsorberMotion, Truth};
use crate::absorber::AbsorberLaws;
use crate::numeric::ode::newton::{Progress, newton};
use crate::numeric::ode::root::{find_minimum, find_root};
use crate::numeric::ode::{IntegrationOptions, Point, Trajectory, integrate_first_order};
use crate::symbol::Symbol;
use crate::values::Values;

/// Samples of a period or of half of one.
const SAMPLES: u32 = 64;

/// A periodic motion of the sink, k = 1.
#[derive(Clone, Copy, Debug)]
struct SinkMotion {
    /// Its start, the largest displacement.
    start: f64,
    /// The parts p and q of the acceleration of the main mass.
    drive: [f64; 2],
}

impl SinkMotion {
    /// The amplitude C of the main mass.
    fn amplitude(self) -> f64 {
        self.drive[0].hypot(self.drive[1])
    }
}

/// The path of the relative motion over half a period.
fn half_period(damping: f64, motion: SinkMotion) -> Option<Trajectory<Point<[f64; 2]>>> {
    let rates = |t: f64, state: &[f64; 2], out: &mut [f64; 2]| {
        let (sine, cosine) = t.sin_cos();
        let drive = motion.drive[0] * cosine + motion.drive[1] * sine;
        *out = [state[1], drive - damping * state[1] - state[0].powi(3)];
    };
    let options = IntegrationOptions::with_tolerance(1e-11);
    let start = Point { t: 0.0, y: [motion.start, 0.0] };
    integrate_first_order(rates, start, PI, &[], &options).ok()
}

/// The periodic motion with this start, near another one.
fn periodic(damping: f64, start: f64, near: SinkMotion) -> Option<SinkMotion> {
    let residual = |drive: &Vector2<f64>| {
        let motion = SinkMotion { start, drive: [drive[0], drive[1]] };
        let end = half_period(damping, motion)?.end().y;
        Some(Vector2::new(end[0] + start, end[1]))
    };
    let equations = |drive: &Vector2<f64>| {
        let mut jacobian = Matrix2::zeros();
        for column in 0..2 {
            const STEP: f64 = 1e-5;
            let mut shifted = [*drive, *drive];
            shifted[0][column] += STEP;
            shifted[1][column] -= STEP;
            let difference = residual(&shifted[0])? - residual(&shifted[1])?;
            jacobian.set_column(column, &(difference / (2.0 * STEP)));
        }
        Some((residual(drive)?, jacobian))
    };
    let judged = |_: &Vector2<f64>, step: &Vector2<f64>| match step.norm() < 1e-9 {
        true => Progress::Settled,
        false => Progress::Going,
    };
    let found = newton(Vector2::new(near.drive[0], near.drive[1]), 20, equations, judged)?;
    Some(SinkMotion { start, drive: [found[0], found[1]] })
}

/// The first harmonic of a motion, and the mean square of its velocity.
fn harmonic(damping: f64, motion: SinkMotion) -> Option<([f64; 2], f64)> {
    let path = half_period(damping, motion)?;
    let (mut first, mut square) = ([0.0; 2], 0.0);
    for sample in 0..SAMPLES {
        let t = PI * f64::from(sample) / f64::from(SAMPLES);
        let state = path.state_at(t)?.y;
        first[0] += 2.0 * state[0] * t.cos() / f64::from(SAMPLES);
        first[1] += 2.0 * state[0] * t.sin() / f64::from(SAMPLES);
        square += state[1] * state[1] / f64::from(SAMPLES);
    }
    Some((first, square))
}

/// The periodic motions from rest to large starts.
fn motions(damping: f64) -> Vec<SinkMotion> {
    const STEP: f64 = 0.03;
    const LARGEST: f64 = 2.5;
    let mut last = SinkMotion { start: 0.0, drive: [0.0, 0.0] };
    let mut found = vec![last];
    while last.start < LARGEST {
        match periodic(damping, last.start + STEP, last) {
            Some(next) => last = next,
            None => break,
        }
        found.push(last);
    }
    found
}

/// The true values of the designs, the manifold, and a motion that slides along it.
pub(super) fn truth(laws: &AbsorberLaws, at: &Values) -> Truth {
    let letter = |name: &str| at.get(Symbol::new(name)).unwrap_or(f64::NAN);
    let (damping, mass_ratio) = (letter("lambda"), letter("eps"));
    // Lengths are in units of 1/sqrt(k).
    let unit = 1.0 / letter("k").sqrt();
    let found = motions(damping);
    let size =
        |motion: SinkMotion| harmonic(damping, motion).map(|(first, _)| first[0].hypot(first[1]));
    let mut values = Vec::new();
    let mut add = |[design, refined]: [Option<&'static str>; 2], name, value: Option<f64>| {
        let value = value.map(|value| value * unit);
        values.extend([design, refined].into_iter().flatten().map(|design| (design, name, value)));
    };
    for (design, sign) in [("upward-jump", -1.0), ("downward-jump", 1.0)] {
        let refined = laws.design(design).and_then(|own| own.refined_by);
        let designs = [Some(design), refined];
        let extreme = found.windows(3).find(|near| {
            let [before, own, after] = [near[0], near[1], near[2]].map(SinkMotion::amplitude);
            sign * (own - before) < 0.0 && sign * (after - own) >= 0.0
        });
        let fold = extreme.and_then(|near| {
            let value = |start: f64| {
                // The search stops at a value that is not positive.
                let motion = periodic(damping, start, near[1]);
                motion.map_or(f64::NAN, |own| (sign * own.amplitude()).exp())
            };
            let (start, _) = find_minimum(value, near[0].start, near[2].start);
            periodic(damping, start, near[1])
        });
        add(designs, "amplitude", fold.map(SinkMotion::amplitude));
        add(designs, "relative_amplitude", fold.and_then(size));
        // A motion of the same C beyond the other fold.
        let landing = fold.and_then(|fold| {
            let beyond = |motion: &SinkMotion| -sign * (motion.start - fold.start) > 0.2;
            let difference = |motion: SinkMotion| motion.amplitude() - fold.amplitude();
            let pair = found
                .windows(2)
                .filter(|pair| pair.iter().all(beyond))
                .find(|pair| difference(pair[0]) * difference(pair[1]) <= 0.0)?;
            let at = |start: f64| periodic(damping, start, pair[0]).map_or(f64::NAN, difference);
            let start = find_root(at, pair[0].start, pair[1].start).ok()?;
            periodic(damping, start, pair[0])
        });
        add(designs, "landing", landing.and_then(size));
        let steady = fold.and_then(|fold| {
            let (first, square) = harmonic(damping, fold)?;
            // The force is the first harmonic of what the sink does to the main mass.
            let force = (fold.drive[0] + first[0]).hypot(fold.drive[1] + first[1]);
            Some([force, 2.0 * damping * square / fold.amplitude()])
        });
        add(designs, "force", steady.map(|steady| steady[0]));
        if sign < 0.0 {
            add(designs, "least_force", steady.map(|steady| steady[1]));
        }
    }
    let (curves, motion) = curves(laws, at, &found, [damping, mass_ratio, unit]);
    Truth { values, curves, motion, ..Truth::default() }
}

/// The manifold by its stability, and the motion of both masses along it.
fn curves(
    laws: &AbsorberLaws,
    at: &Values,
    found: &[SinkMotion],
    [damping, mass_ratio, unit]: [f64; 3],
) -> (Vec<AbsorberCurve>, Option<AbsorberMotion>) {
    const POINTS: u32 = 200;
    let value = |design: &str, name: &str| laws.named_value(design, name, at);
    let pairs = ["upward-jump", "downward-jump"].map(|design| {
        let (amplitude, relative) =
            (value(design, "amplitude")?, value(design, "relative_amplitude")?);
        Some([amplitude, relative, value(design, "landing")?])
    });
    let [Some(lower), Some(upper)] = pairs else { return (vec![], None) };
    let manifold = |relative: f64| {
        let square = (relative / unit).powi(2);
        relative * (1.0 - 0.75 * square).hypot(damping)
    };
    let part = |from: f64, to: f64| -> Vec<(f64, f64)> {
        (0..=POINTS)
            .map(|step| from + (to - from) * f64::from(step) / f64::from(POINTS))
            .map(|relative| (manifold(relative), relative))
            .collect()
    };
    let curve = |label: &str, kind, points| AbsorberCurve { label: label.to_owned(), kind, points };
    // Both masses from a periodic motion above the lower fold.
    let start = found
        .iter()
        .filter(|motion| motion.start * unit > upper[1])
        .find(|motion| motion.amplitude() * unit > 1.3 * lower[0]);
    let slide: Vec<(f64, f64)> = start.map_or(vec![], |start| {
        let rows = slide(damping, mass_ratio, *start, upper[1] / unit);
        rows.into_iter().map(|(amplitude, relative)| (amplitude * unit, relative * unit)).collect()
    });
    let largest = slide.iter().map(|row| row.1).fold(1.1 * lower[2], f64::max);
    let words = "both masses set free on the manifold, until the sink is at the upper fold";
    let motion = AbsorberMotion::along(&part(upper[1], largest), &slide, words);
    let curves = vec![
        curve("two masses set free", AbsorberCurveKind::Truth, slide),
        curve("manifold, stable", AbsorberCurveKind::Formula, part(0.0, lower[1])),
        curve("manifold, stable", AbsorberCurveKind::Formula, part(upper[1], largest)),
        curve("unstable", AbsorberCurveKind::Unstable, part(lower[1], upper[1])),
        curve(
            "jumps",
            AbsorberCurveKind::Background,
            vec![(lower[0], lower[1]), (lower[0], lower[2])],
        ),
        curve(
            "jumps",
            AbsorberCurveKind::Background,
            vec![(upper[0], upper[1]), (upper[0], upper[2])],
        ),
        curve("folds", AbsorberCurveKind::Points, vec![(lower[0], lower[1]), (upper[0], upper[1])]),
    ];
    (curves, motion)
}

/// The first harmonics of main mass and relative motion, period by period, of both masses set free,
/// until the sink has less than an amplitude.
fn slide(damping: f64, mass_ratio: f64, start: SinkMotion, least: f64) -> Vec<(f64, f64)> {
    const MOST_PERIODS: usize = 3_000;
    let rates = |_: f64, state: &[f64; 4], out: &mut [f64; 4]| {
        let [x, y, u, v] = *state;
        let link = damping * (u - v) + (x - y).powi(3);
        *out = [u, v, -x - mass_ratio * link, link];
    };
    // x'' = -x = p cos t + q sin t.
    let [p, q] = start.drive;
    let mut state = [-p, -p - start.start, -q, -q];
    let options = IntegrationOptions::with_tolerance(1e-9);
    let mut rows = Vec::new();
    while rows.len() < MOST_PERIODS {
        let from = Point { t: 0.0, y: state };
        let Ok(path) = integrate_first_order(rates, from, TAU, &[], &options) else { break };
        let mut sums = [0.0; 4];
        for sample in 0..SAMPLES {
            let t = TAU * f64::from(sample) / f64::from(SAMPLES);
            let Some(own) = path.state_at(t).map(|own| own.y) else { return rows };
            let (sine, cosine) = t.sin_cos();
            let weight = 2.0 / f64::from(SAMPLES);
            for (sum, wave) in sums.iter_mut().zip([
                own[0] * cosine,
                own[0] * sine,
                (own[0] - own[1]) * cosine,
                (own[0] - own[1]) * sine,
            ]) {
                *sum += weight * wave;
            }
        }
        let relative = sums[2].hypot(sums[3]);
        if relative < least {
            break;
        }
        rows.push((sums[0].hypot(sums[1]), relative));
        state = path.end().y;
    }
    rows
}

//! A body between two walls of a main mass, from impact to impact: a ball in its cavity, or a pendulum
//! between barriers.
//!
//! Between impacts both masses are a linear system, with the displacement y relative to the main mass
//!
//! ```text
//! q = (x, y),  q'' = -A q,  A = (1, -mu w^2; -1, (1 + mu) w^2),   q(t) = cos(sqrt(A) t) q(0) + sin(sqrt(A) t)/sqrt(A) q'(0)
//! ```
//!
//! and the time of the next impact is the root of `|y| = b`. A body without mass beside a main mass that
//! moves as `C cos t` gives the least amplitude and the loss of stability; a body with mass, which takes
//! energy at each impact, the motion that slides along the manifold.

use std::f64::consts::PI;

use nalgebra::{Matrix2, Vector2};

use super::{
    AbsorberCurve, AbsorberCurveKind, AbsorberDecay, AbsorberMotion, AbsorberTouch, Truth,
};
use crate::absorber::{AbsorberKind, AbsorberLaws};
use crate::expr::Expr;
use crate::numeric::ode::newton::{Progress, newton};
use crate::numeric::ode::root::{BisectionStop, bisect, find_minimum, find_root};
use crate::symbol::Symbol;
use crate::values::Values;

/// A body between walls of its main mass.
#[derive(Clone, Copy)]
struct BetweenWalls {
    restitution: f64,
    half_width: f64,
    mass_ratio: f64,
    /// The frequency w of the body alone, 0 of a ball.
    frequency: f64,
}

/// The state just after an impact.
#[derive(Clone, Copy, Debug)]
struct AfterImpact {
    /// The time.
    t: f64,
    /// The main mass and its velocity.
    x: f64,
    x_rate: f64,
    /// The side of the wall that was hit, 1 or -1.
    side: f64,
    /// The velocity of the body relative to the main mass.
    y_rate: f64,
}

/// A motion with two impacts a period of a body without mass beside a main mass that moves as `C cos t`.
#[derive(Clone, Copy, Debug)]
struct MotionAtPhase {
    /// The time of the impact on the wall of side 1.
    phase: f64,
    /// C.
    amplitude: f64,
    /// The relative velocity of the body after that impact.
    y_rate: f64,
}

impl BetweenWalls {
    /// `kappa = w cot(pi w/2)`.
    fn kappa(&self) -> f64 {
        match self.frequency {
            0.0 => 2.0 / PI,
            own => own / (PI * own / 2.0).tan(),
        }
    }

    /// The amplitude `Z = y + x/(1 - w^2)` of the body after an impact with the main mass at this place.
    fn amplitude(&self, x: f64, side: f64) -> f64 {
        self.half_width + side * x / (1.0 - self.frequency.powi(2))
    }

    /// The amplitude Z at which the body touches a wall between its two impacts a period, beyond which
    /// there is no such motion; `None` if there is none up to `largest`.
    fn touch(&self, [least, largest]: [f64; 2]) -> Option<f64> {
        const RATIO: f64 = 1.02;
        let is_free = |amplitude: f64| self.farthest(amplitude) <= self.half_width;
        let mut free = least * 1.001;
        while is_free(free) {
            if free >= largest {
                return None;
            }
            let next = (free * RATIO).min(largest);
            if !is_free(next) {
                let [last, _] = bisect(&is_free, free, next, BisectionStop::Halvings(40));
                return Some(last);
            }
            free = next;
        }
        Some(free)
    }

    /// The greatest distance of a body without mass from the middle between the impacts of the motion with
    /// this amplitude, away from the impacts themselves.
    fn farthest(&self, amplitude: f64) -> f64 {
        const PLACES: u32 = 200;
        let motion = self.on_manifold(amplitude);
        let (sine, cosine) = motion.phase.sin_cos();
        let from = AfterImpact {
            t: 0.0,
            x: motion.amplitude * cosine,
            x_rate: -motion.amplitude * sine,
            side: 1.0,
            y_rate: motion.y_rate,
        };
        let distance = |time: f64| self.flight(from, time)[0].y.abs();
        let time = |place: u32| PI * f64::from(place) / f64::from(PLACES);
        let inner = (1..PLACES).map(|place| (distance(time(place)), place));
        match inner.max_by(|one, other| one.0.total_cmp(&other.0)) {
            Some((_, place)) if (2..PLACES - 1).contains(&place) => {
                let [low, high] = [place - 1, place + 1].map(time);
                -find_minimum(|at| -distance(at), low, high).1
            }
            inner => inner.map_or(0.0, |(distance, _)| distance),
        }
    }

    /// The motion on the manifold with this amplitude Z, as a first guess.
    fn on_manifold(&self, amplitude: f64) -> MotionAtPhase {
        let loss = (1.0 - self.restitution) / (1.0 + self.restitution);
        let forced = 1.0 - self.frequency.powi(2);
        let speed = self.kappa() * amplitude;
        let (x, rate) = (forced * (amplitude - self.half_width), forced * loss * speed);
        let y_rate = -(1.0 - loss) * speed;
        MotionAtPhase { phase: rate.atan2(x), amplitude: x.hypot(rate), y_rate }
    }

    /// Displacements of the main mass and the body, and the velocities of both, a time after an impact.
    fn flight(&self, from: AfterImpact, time: f64) -> [Vector2<f64>; 2] {
        let (mu, square) = (self.mass_ratio, self.frequency.powi(2));
        let system = Matrix2::new(1.0, -mu * square, -1.0, (1.0 + mu) * square);
        let (middle, product) = (system.trace() / 2.0, square);
        let high = middle + (middle * middle - product).max(0.0).sqrt();
        let eigenvalues = [high, product / high];
        let [first, second] = eigenvalues.map(|square| {
            let own = square.sqrt();
            let (sine, cosine) = (own * time).sin_cos();
            [cosine, if own > 0.0 { sine / own } else { time }, -own * sine]
        });
        let spread = system - Matrix2::identity() * eigenvalues[0];
        let of = |place: usize| {
            let slope = (second[place] - first[place]) / (eigenvalues[1] - eigenvalues[0]);
            Matrix2::identity() * first[place] + spread * slope
        };
        let place = Vector2::new(from.x, from.side * self.half_width);
        let rate = Vector2::new(from.x_rate, from.y_rate);
        [of(0) * place + of(1) * rate, of(2) * place + of(0) * rate]
    }

    /// The state after the next impact; `None` if there is none within two periods.
    fn next(&self, from: AfterImpact) -> Option<AfterImpact> {
        const STEPS: u32 = 400;
        let relative = |time: f64| self.flight(from, time)[0].y;
        let step = 4.0 * PI / f64::from(STEPS);
        let mut last = 0.0;
        for count in 1..=STEPS {
            let time = step * f64::from(count);
            let y = relative(time);
            if y.abs() > self.half_width {
                let side = y.signum();
                let beyond = |time: f64| side * relative(time) - self.half_width;
                // Just after an impact the body is at the wall that it leaves.
                let begin = if last == 0.0 && side == from.side { step * 1e-6 } else { last };
                let time = find_root(beyond, begin, time).ok()?;
                let [place, rate] = self.flight(from, time);
                let change = -(1.0 + self.restitution) * rate.y;
                return Some(AfterImpact {
                    t: from.t + time,
                    x: place.x,
                    x_rate: rate.x - self.mass_ratio / (1.0 + self.mass_ratio) * change,
                    side,
                    y_rate: rate.y + change,
                });
            }
            last = time;
        }
        None
    }

    /// Phase and velocity after the next impact, mirrored, from those after an impact of a body
    /// without mass on the wall of side 1; `None` if the next is on the same wall.
    fn mirrored(&self, amplitude: f64, [phase, y_rate]: [f64; 2]) -> Option<[f64; 2]> {
        let (sine, cosine) = phase.sin_cos();
        let from = AfterImpact {
            t: phase,
            x: amplitude * cosine,
            x_rate: -amplitude * sine,
            side: 1.0,
            y_rate,
        };
        let next = self.next(from).filter(|next| next.side < 0.0)?;
        Some([next.t - PI, -next.y_rate])
    }

    /// The motion with two impacts a period whose impacts have this phase, near another one.
    fn at_phase(&self, phase: f64, near: MotionAtPhase) -> Option<MotionAtPhase> {
        let residual = |at: &Vector2<f64>| {
            let next = self.mirrored(at[0], [phase, at[1]])?;
            Some(Vector2::new(next[0] - phase, next[1] - at[1]))
        };
        let equations = |at: &Vector2<f64>| {
            let mut jacobian = Matrix2::zeros();
            for column in 0..2 {
                let step = 1e-6 * at[column].abs();
                let mut shifted = [*at, *at];
                shifted[0][column] += step;
                shifted[1][column] -= step;
                let difference = residual(&shifted[0])? - residual(&shifted[1])?;
                jacobian.set_column(column, &(difference / (2.0 * step)));
            }
            Some((residual(at)?, jacobian))
        };
        let judged = |at: &Vector2<f64>, step: &Vector2<f64>| match step.norm() < 1e-11 * at.norm()
        {
            true => Progress::Settled,
            false => Progress::Going,
        };
        let found = newton(Vector2::new(near.amplitude, near.y_rate), 30, equations, judged)?;
        Some(MotionAtPhase { phase, amplitude: found[0], y_rate: found[1] })
    }

    /// The motion to which a body without mass settles beside a main mass of this amplitude.
    fn settled(&self, amplitude: f64, start: [f64; 2]) -> Option<MotionAtPhase> {
        const IMPACTS: u32 = 20_000;
        let mut state = start;
        for _ in 0..IMPACTS {
            let next = self.mirrored(amplitude, state)?;
            let change = (next[0] - state[0]).abs() + (next[1] / state[1] - 1.0).abs();
            state = next;
            if change < 1e-12 {
                break;
            }
        }
        let again = self.mirrored(amplitude, state)?;
        let is_still = (again[0] - state[0]).abs() < 1e-9;
        is_still.then_some(MotionAtPhase { phase: state[0], amplitude, y_rate: state[1] })
    }

    /// The last two motions at phases from one on, for the second of which `goes_on` is false.
    fn followed(
        &self,
        from: MotionAtPhase,
        next_phase: impl Fn(f64) -> f64,
        goes_on: impl Fn(MotionAtPhase, MotionAtPhase) -> bool,
    ) -> Option<[MotionAtPhase; 2]> {
        let mut last = from;
        loop {
            let phase = next_phase(last.phase);
            if !(1e-6..PI).contains(&phase) {
                return None;
            }
            let next = self.at_phase(phase, last)?;
            if !goes_on(last, next) {
                return Some([last, next]);
            }
            last = next;
        }
    }

    /// The motion of the least amplitude.
    fn least(&self, from: MotionAtPhase) -> Option<MotionAtPhase> {
        // From Z = b on, phases change by atan(s kappa) until C is least.
        let loss = (1.0 - self.restitution) / (1.0 + self.restitution);
        let step = 0.05 * loss * self.kappa();
        let is_less = |last: MotionAtPhase, next: MotionAtPhase| next.amplitude < last.amplitude;
        let [last, next] = self.followed(from, |phase| phase + step, is_less)?;
        let amplitude =
            |phase: f64| self.at_phase(phase, last).map_or(f64::INFINITY, |own| own.amplitude);
        let (phase, _) = find_minimum(amplitude, last.phase - step, next.phase);
        self.at_phase(phase, last)
    }

    /// The motion with a multiplier of -1.
    fn period_doubling(&self, from: MotionAtPhase) -> Option<MotionAtPhase> {
        let value = |motion: MotionAtPhase| self.at_minus_one(motion).unwrap_or(f64::NAN);
        let [last, next] =
            self.followed(from, |phase| 0.98 * phase, |_, next| value(next) > 0.0)?;
        let at = |phase: f64| self.at_phase(phase, last).map_or(f64::NAN, value);
        let phase = find_root(at, last.phase, next.phase).ok()?;
        self.at_phase(phase, last)
    }

    /// `1 + trace + determinant` of the map of impacts at a motion: zero at a multiplier of -1.
    fn at_minus_one(&self, motion: MotionAtPhase) -> Option<f64> {
        let slope = |place: usize| {
            let step = 1e-5 * [1.0, motion.y_rate.abs()][place];
            let shifted = |sign: f64| {
                let mut state = [motion.phase, motion.y_rate];
                state[place] += sign * step;
                self.mirrored(motion.amplitude, state)
            };
            let (after, before) = (shifted(1.0)?, shifted(-1.0)?);
            Some([(after[0] - before[0]) / (2.0 * step), (after[1] - before[1]) / (2.0 * step)])
        };
        let [a, b] = [slope(0)?, slope(1)?];
        Some(1.0 + a[0] + b[1] + a[0] * b[1] - a[1] * b[0])
    }
}

/// The true values of the designs, the manifold, and a motion that slides along it.
pub(super) fn truth(laws: &AbsorberLaws, at: &Values) -> Truth {
    let letter = |name: &str| at.get(Symbol::new(name)).unwrap_or(f64::NAN);
    let half_width = letter("b");
    let light = BetweenWalls {
        restitution: letter("r"),
        half_width,
        mass_ratio: 0.0,
        frequency: at.get(Symbol::new("w")).unwrap_or(0.0),
    };
    let body = match laws.kind {
        AbsorberKind::PendulumSink => "pendulum_amplitude",
        _ => "ball_amplitude",
    };
    let value = |design: &str| laws.named_value(design, body, at).filter(|own| *own > 0.0);
    // Where Z = b, the main mass passes its middle at the impact.
    let guess = light.on_manifold(half_width);
    let settled = light.settled(guess.amplitude, [guess.phase, guess.y_rate]);
    let least = settled.and_then(|motion| light.least(motion));
    let most = settled.and_then(|motion| light.period_doubling(motion));
    let mut values = Vec::new();
    for (design, motion) in [("threshold", least), ("period-doubling", most)] {
        values.push((design, "amplitude", motion.map(|motion| motion.amplitude)));
        let place = |motion: MotionAtPhase| motion.amplitude * motion.phase.cos();
        values.push((design, body, motion.map(|motion| light.amplitude(place(motion), 1.0))));
    }
    let Some(least) = value("threshold") else { return Truth { values, ..Truth::default() } };
    let touch = light.touch([least, value("period-doubling").unwrap_or(1e3 * half_width)]);
    // Beyond a touch there is no motion that could lose its stability.
    let absent = touch.map(|_| "period-doubling");
    let most = value("period-doubling").filter(|_| touch.is_none());
    let heavy = BetweenWalls { mass_ratio: letter("mu"), ..light };
    let end = match (touch, most) {
        (Some(touch), _) => touch.min(5.0 * half_width),
        (None, Some(most)) => 1.2 * most,
        (None, None) => 5.0 * half_width,
    };
    let first = (half_width + most.unwrap_or(end)) / 2.0;
    let slide = heavy.slide(light.on_manifold(first), least);
    let manifold = |amplitude: f64| light.on_manifold(amplitude).amplitude;
    let words = "both masses set free on the manifold, as long as there are two impacts a period";
    let points: Vec<(f64, f64)> = (0..=2_000)
        .map(|step| end * f64::from(step) / 2_000.0)
        .map(|own| (manifold(own), own))
        .collect();
    let decay = decay(laws, at, first, &manifold, &slide);
    let slide: Vec<(f64, f64)> = slide.into_iter().map(|(_, point)| point).collect();
    let motion = AbsorberMotion::along(&points, &slide, words)
        .map(|motion| AbsorberMotion { decay, ..motion });
    let curves = curves(&manifold, least, most, end, slide);
    let touch = touch.map(|sink| AbsorberTouch { amplitude: manifold(sink), sink });
    Truth { values, curves, motion, absent, touch, lowest_peak: None }
}

impl BetweenWalls {
    /// The time and the amplitudes of the main mass and of the body, impact by impact, of masses set
    /// free, until the body has less than an amplitude or loses step.
    fn slide(&self, start: MotionAtPhase, least: f64) -> Vec<(f64, (f64, f64))> {
        const MOST: usize = 20_000;
        let (sine, cosine) = start.phase.sin_cos();
        let mut state = AfterImpact {
            t: 0.0,
            x: start.amplitude * cosine,
            x_rate: -start.amplitude * sine,
            side: 1.0,
            y_rate: start.y_rate,
        };
        let mut found = Vec::new();
        while found.len() < MOST {
            let Some(next) = self.next(state) else { break };
            let is_in_step = next.side != state.side && (next.t - state.t - PI).abs() < 0.7;
            let amplitude = self.amplitude(next.x, next.side);
            if !is_in_step || amplitude < least {
                break;
            }
            state = next;
            found.push((state.t, (state.x.hypot(state.x_rate), amplitude)));
        }
        found
    }
}

/// The time in which the main mass falls from the amplitude where the sink has this one at the start to that
/// where it has the amplitude b, with impacts where the main mass passes its middle, or half of the way
/// if it loses step before; `None` if it does neither.
fn decay(
    laws: &AbsorberLaws,
    at: &Values,
    first: f64,
    manifold: &dyn Fn(f64) -> f64,
    slide: &[(f64, (f64, f64))],
) -> Option<AbsorberDecay> {
    let width = at.get(Symbol::new("b"))?;
    let passed = [width, (first + width) / 2.0].into_iter().find_map(|last| {
        let end = manifold(last);
        let mut pairs = slide.windows(2);
        Some((last, end, pairs.find(|pair| pair[0].1.0 >= end && pair[1].1.0 < end)?))
    });
    let (last, end, pair) = passed?;
    let [(before, (high, _)), (after, (low, _))] = [pair[0], pair[1]];
    let truth = before + (after - before) * (high - end) / (high - low);
    let mut numbers = at.with(Symbol::new("Z0"), first);
    numbers.insert(Symbol::new("Z"), last);
    let formula = laws.relation_value(&Expr::symbol("t"), numbers)?;
    Some(AbsorberDecay { amplitudes: [manifold(first), end], formula, truth })
}

/// The manifold by its stability, and the motion along it; `most` is `None` where the motion is stable
/// until a wall is touched.
fn curves(
    manifold: &dyn Fn(f64) -> f64,
    least: f64,
    most: Option<f64>,
    end: f64,
    slide: Vec<(f64, f64)>,
) -> Vec<AbsorberCurve> {
    const POINTS: u32 = 200;
    let part = |from: f64, to: f64| -> Vec<(f64, f64)> {
        (0..=POINTS)
            .map(|step| from + (to - from) * f64::from(step) / f64::from(POINTS))
            .map(|own| (manifold(own), own))
            .collect()
    };
    let curve = |label: &str, kind, points| AbsorberCurve { label: label.to_owned(), kind, points };
    let stable = part(least, most.unwrap_or(end));
    let mut curves = vec![
        curve("two masses set free", AbsorberCurveKind::Truth, slide),
        curve("two impacts a period, stable", AbsorberCurveKind::Formula, stable),
        curve("unstable", AbsorberCurveKind::Unstable, part(0.4 * least, least)),
    ];
    let mut points = vec![(manifold(least), least)];
    let mut words = "least amplitude";
    if let Some(most) = most {
        curves.push(curve("unstable", AbsorberCurveKind::Unstable, part(most, end)));
        points.push((manifold(most), most));
        words = "least amplitude, period doubling";
    }
    curves.push(curve(words, AbsorberCurveKind::Points, points));
    curves
}

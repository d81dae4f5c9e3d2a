//! A ball in the cavity of a main mass, from impact to impact.
//!
//! Between impacts both motions are known exactly, and the time of the next impact is the root of
//! `|y - x| = b`. A ball without mass in a cavity that moves as `C cos t` gives the least amplitude
//! and the loss of stability; a ball with mass, which takes energy at each impact, the motion that
//! slides along the manifold.

use std::f64::consts::PI;

use nalgebra::{Matrix2, Vector2};

use super::{AbsorberCurve, AbsorberCurveKind, AbsorberDecay, AbsorberMotion, Truth};
use crate::absorber::AbsorberLaws;
use crate::expr::Expr;
use crate::numeric::ode::newton::{Progress, newton};
use crate::numeric::ode::root::{find_minimum, find_root};
use crate::symbol::Symbol;
use crate::values::Values;

/// A ball and its main mass.
#[derive(Clone, Copy)]
struct BallInCavity {
    restitution: f64,
    half_width: f64,
    mass_ratio: f64,
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
    /// The velocity of the ball.
    y_rate: f64,
}

/// A motion with two impacts a period of a ball without mass in a cavity that moves as `C cos t`.
#[derive(Clone, Copy, Debug)]
struct MotionAtPhase {
    /// The time of the impact on the wall of side 1.
    phase: f64,
    /// C.
    amplitude: f64,
    /// The velocity of the ball after that impact.
    y_rate: f64,
}

impl MotionAtPhase {
    /// The amplitude of the ball.
    fn ball(self) -> f64 {
        self.y_rate.abs() * PI / 2.0
    }
}

impl BallInCavity {
    /// The state after the next impact; `None` if there is none within two periods.
    fn next(&self, from: AfterImpact) -> Option<AfterImpact> {
        const STEPS: u32 = 400;
        let y = from.x + from.side * self.half_width;
        let main = |time: f64| {
            let (sine, cosine) = time.sin_cos();
            [from.x * cosine + from.x_rate * sine, from.x_rate * cosine - from.x * sine]
        };
        let relative = |time: f64| y + from.y_rate * time - main(time)[0];
        let step = 4.0 * PI / f64::from(STEPS);
        let mut last = 0.0;
        for count in 1..=STEPS {
            let time = step * f64::from(count);
            let side = relative(time).signum();
            if relative(time).abs() > self.half_width {
                let beyond = |time: f64| side * relative(time) - self.half_width;
                // Just after an impact the ball is at the wall that it leaves.
                let begin = if last == 0.0 && side == from.side { step * 1e-6 } else { last };
                let time = find_root(beyond, begin, time).ok()?;
                let [x, x_rate] = main(time);
                let loss =
                    (1.0 + self.restitution) * (from.y_rate - x_rate) / (1.0 + self.mass_ratio);
                return Some(AfterImpact {
                    t: from.t + time,
                    x,
                    x_rate: x_rate + self.mass_ratio * loss,
                    side,
                    y_rate: from.y_rate - loss,
                });
            }
            last = time;
        }
        None
    }

    /// Phase and velocity after the next impact, mirrored, from those after an impact of a ball
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

    /// The motion to which a ball without mass settles in a cavity of this amplitude.
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
        // Phases change with the velocity of the walls, which is small where little is lost.
        let step = 0.02 * (1.0 - self.restitution);
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
    let (restitution, half_width) = (letter("r"), letter("b"));
    let loss = (1.0 - restitution) / (1.0 + restitution);
    let light = BallInCavity { restitution, half_width, mass_ratio: 0.0 };
    let value = |design: &str, name: &str| laws.named_value(design, name, at);
    // The motion on the manifold with this amplitude of the ball, as a first guess.
    let on_manifold = |ball: f64| {
        let (x, rate) = (ball - half_width, 2.0 * loss * ball / PI);
        MotionAtPhase { phase: rate.atan2(x), amplitude: x.hypot(rate), y_rate: -2.0 * ball / PI }
    };
    let balls =
        value("threshold", "ball_amplitude").zip(value("period-doubling", "ball_amplitude"));
    // With the ball as far as the wall, the main mass passes its middle at the impact.
    let guess = on_manifold(half_width);
    let settled = light.settled(guess.amplitude, [guess.phase, guess.y_rate]);
    let least = settled.and_then(|motion| light.least(motion));
    let most = settled.and_then(|motion| light.period_doubling(motion));
    let mut values = Vec::new();
    for (design, motion) in [("threshold", least), ("period-doubling", most)] {
        values.push((design, "amplitude", motion.map(|motion| motion.amplitude)));
        values.push((design, "ball_amplitude", motion.map(MotionAtPhase::ball)));
    }
    let heavy = BallInCavity { mass_ratio: letter("mu"), ..light };
    let (start, end) = match balls {
        Some((_, most)) => (on_manifold((half_width + most) / 2.0), 1.2 * most),
        None => return Truth { values, ..Truth::default() },
    };
    let slide = heavy.slide(start, balls.map_or(0.0, |(least, _)| least));
    let manifold = |ball: f64| on_manifold(ball).amplitude;
    let words = "both masses set free on the manifold, as long as there are two impacts a period";
    let points: Vec<(f64, f64)> = (0..=2_000)
        .map(|step| end * f64::from(step) / 2_000.0)
        .map(|ball| (manifold(ball), ball))
        .collect();
    let decay = decay(laws, at, start.ball(), &slide);
    let slide: Vec<(f64, f64)> = slide.into_iter().map(|(_, point)| point).collect();
    let motion = AbsorberMotion::along(&points, &slide, words)
        .map(|motion| AbsorberMotion { decay, ..motion });
    let curves = curves(&manifold, balls, end, slide);
    Truth { values, curves, motion, lowest_peak: None }
}

impl BallInCavity {
    /// The time and the amplitudes of the main mass and of the ball, impact by impact, of masses set
    /// free, until the ball has less than an amplitude or loses step.
    fn slide(&self, start: MotionAtPhase, least_ball: f64) -> Vec<(f64, (f64, f64))> {
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
            let ball = next.y_rate.abs() * PI / 2.0;
            if !is_in_step || ball < least_ball {
                break;
            }
            state = next;
            found.push((state.t, (state.x.hypot(state.x_rate), ball)));
        }
        found
    }
}

/// The time in which the ball falls from its amplitude at the start to the amplitude b, at which it turns
/// where the main mass passes its middle; `None` if it does not.
fn decay(
    laws: &AbsorberLaws,
    at: &Values,
    first: f64,
    slide: &[(f64, (f64, f64))],
) -> Option<AbsorberDecay> {
    let last = at.get(Symbol::new("b"))?;
    let pair = slide.windows(2).find(|pair| pair[0].1.1 >= last && pair[1].1.1 < last)?;
    let [(before, (_, high)), (after, (_, low))] = [pair[0], pair[1]];
    let truth = before + (after - before) * (high - last) / (high - low);
    let mut numbers = at.with(Symbol::new("Z0"), first);
    numbers.insert(Symbol::new("Z"), last);
    let formula = laws.relation_value(&Expr::symbol("t"), numbers)?;
    Some(AbsorberDecay { amplitudes: [first, last], formula, truth })
}

/// The manifold by its stability, and the motion along it.
fn curves(
    manifold: &dyn Fn(f64) -> f64,
    balls: Option<(f64, f64)>,
    end: f64,
    slide: Vec<(f64, f64)>,
) -> Vec<AbsorberCurve> {
    const POINTS: u32 = 200;
    let Some((least, most)) = balls else { return vec![] };
    let part = |from: f64, to: f64| -> Vec<(f64, f64)> {
        (0..=POINTS)
            .map(|step| from + (to - from) * f64::from(step) / f64::from(POINTS))
            .map(|ball| (manifold(ball), ball))
            .collect()
    };
    let curve = |label: &str, kind, points| AbsorberCurve { label: label.to_owned(), kind, points };
    vec![
        curve("two masses set free", AbsorberCurveKind::Truth, slide),
        curve("two impacts a period, stable", AbsorberCurveKind::Formula, part(least, most)),
        curve("unstable", AbsorberCurveKind::Unstable, part(0.4 * least, least)),
        curve("unstable", AbsorberCurveKind::Unstable, part(most, end)),
        curve(
            "least amplitude, period doubling",
            AbsorberCurveKind::Points,
            vec![(manifold(least), least), (manifold(most), most)],
        ),
    ]
}

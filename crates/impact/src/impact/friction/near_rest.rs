//! A swing with friction, to rest: Coulomb's law stops it for good, the arctangent of equation (6)
//! lets it creep.
//!
//! ```text
//! c     = alpha (2/pi) 100                                  the damping of equation (6) near rest, x'' + c x' + x = 0
//! rate  = (c - sqrt(c^2 - 4))/2                             its slow motion where c > 2, and c/2 where it swings
//! rate ~ pi/(200 alpha)                                     for c far above 2
//! y = sin(pi sin(x)/(2 alpha)),  y' = -pi cos(x)/(200 alpha) y   x'' left out: alpha (2/pi) atan(100 x') = -sin x
//! W/W_C = (sqrt(1 + k^2) - 1)/k                             the work of a harmonic swing of speed V = k/100 over Coulomb's
//! ```
//!
//! The last formula is by averaging, (1/2) int_0^pi (2/pi) atan(k sin s) sin s ds. Every formula is
//! compared with the simulation of the whole equation.

use std::f64::consts::{FRAC_2_PI, PI, TAU};

use super::FrictionError;
use crate::impact::model::{Friction, Model, STEEPNESS, Start};
use crate::impact::simulate::simulate;
use crate::impact::simulation::{
    Integrator, NoRest, Regime, Settings, Simulation, SimulationStop, TurningPoint,
};
use crate::numeric::ode::{IntegrationOptions, Point, Trajectory, integrate_first_order};

/// The first cycle by the arctangent.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FirstCycle {
    /// When it ends, in units of time.
    pub until: f64,
    /// The largest error of the force, as a fraction of alpha: all of it, where the motion turns
    /// back.
    pub largest_error: f64,
    /// The part of the time in which the force errs by more than 1 % of alpha.
    pub over_one_percent: f64,
    /// The part of the time in which it errs by more than 10 %.
    pub over_ten_percent: f64,
    /// The work of the arctangent along this motion over that of Coulomb's law.
    pub work_share: f64,
    /// The same by the formula of a harmonic swing, (sqrt(1 + k^2) - 1)/k with k = 100 times the
    /// greatest speed.
    pub work_share_formula: f64,
}

/// A state after the stop.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CreepSample {
    /// The time since both were at rest where Coulomb's law stops the swing, in units of time.
    pub t: f64,
    /// Where the arctangent has taken it, in radians; Coulomb's law leaves it where it is.
    pub x: f64,
    /// The same by the formula without inertia, in radians; null where it swings.
    pub formula: Option<f64>,
}

/// The motion by the arctangent from rest at the place where Coulomb's law holds the pendulum.
#[derive(Debug, Clone)]
pub struct Creep {
    /// c, the linear damping near rest.
    pub damping: f64,
    /// Whether it creeps, c > 2; it swings about zero otherwise.
    pub creeps: bool,
    /// The rate for c far above 2, pi/(200 alpha); `None` if it swings.
    pub rate_overdamped: Option<f64>,
    /// The rate of the linear equation.
    pub rate_linear: f64,
    /// The rate of the simulated motion, when it is small; `None` if there is no motion.
    pub rate: Option<f64>,
    /// States at some times.
    pub samples: Vec<CreepSample>,
    without_inertia: Option<WithoutInertia>,
    /// The motion.
    pub motion: Simulation,
}

impl Creep {
    /// The position by the formula of the creep, this long after rest, rad, up to the end of the
    /// motion; `None` if it swings.
    pub fn formula(&self, t: f64) -> Option<f64> {
        self.without_inertia.as_ref()?.position_at(t)
    }
}

/// Rest times of the default pendulum at its barrier, with friction alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestTimes {
    /// The rest time by Coulomb's law.
    pub coulomb: Result<f64, NoRest>,
    /// The rest time by the arctangent.
    pub arctangent: Result<f64, NoRest>,
}

impl RestTimes {
    /// Rest time by the arctangent minus that by Coulomb's law; `None` if either is not known.
    pub fn difference(&self) -> Option<f64> {
        Some(self.arctangent.ok()? - self.coulomb.ok()?)
    }
}

/// A swing with friction, by both laws.
#[derive(Debug, Clone)]
pub struct NearRest {
    /// Time and position at which Coulomb's law stops it for good.
    pub stop: TurningPoint,
    /// The half swings until then.
    pub half_swings: usize,
    /// The state by the arctangent at that time: displacement and velocity.
    pub meanwhile: [f64; 2],
    /// The effect of the arctangent on the first cycle.
    pub first_cycle: FirstCycle,
    /// The motion by the arctangent near rest.
    pub creep: Creep,
    /// Rest times of the default pendulum at its barrier.
    pub rest_times: RestTimes,
    /// The motions from the release, by Coulomb's law and by the arctangent, until well after the
    /// stop.
    pub motions: [Simulation; 2],
}

/// The rate at which the arctangent's motion dies near rest, from its linear damping c: the slow
/// one of two, or that of both.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::friction::slow_rate;
///
/// assert_eq!(slow_rate(2.5), 0.5); // (s + 2)(s + 1/2)
/// assert_eq!(slow_rate(0.2), 0.1);
/// ```
pub fn slow_rate(damping: f64) -> f64 {
    match damping > 2.0 {
        // 2/(c + sqrt(c^2 - 4)), which does not cancel.
        true => 2.0 / (damping + ((damping - 2.0) * (damping + 2.0)).sqrt()),
        false => 0.5 * damping,
    }
}

/// The work of the friction of equation (6) in a harmonic swing of this greatest speed, over that
/// of Coulomb's law.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::friction::work_share;
///
/// assert!((work_share(0.01) - (2.0_f64.sqrt() - 1.0)).abs() < 1e-15);
/// assert!(work_share(1.0) < 0.991 && work_share(10.0) > 0.999);
/// ```
pub fn work_share(speed: f64) -> f64 {
    let k = STEEPNESS * speed;
    // (sqrt(1 + k^2) - 1)/k, which does not cancel.
    k / (1.0 + k.hypot(1.0))
}

/// A pendulum without a barrier.
fn swing(
    alpha: f64,
    friction: Friction,
    x: f64,
    duration: f64,
) -> Result<Simulation, FrictionError> {
    let model = Model { alpha, friction, right: None, ..Model::default() };
    followed(&model, x, duration)
}

fn followed(model: &Model, x: f64, duration: f64) -> Result<Simulation, FrictionError> {
    let settings = Settings { duration, ..Settings::default() };
    let motion = simulate(model, Start { x, velocity: 0.0 }, Integrator::Taylor, &settings)?;
    match motion.stop {
        SimulationStop::Duration => Ok(motion),
        _ => Err(FrictionError::Restless(model.alpha)),
    }
}

/// The final stop by Coulomb's law, and the number of half swings before it.
fn final_stop(alpha: f64, amplitude: f64) -> Result<(TurningPoint, usize), FrictionError> {
    let mut duration = 50.0;
    loop {
        let motion = swing(alpha, Friction::Exact, -amplitude, duration)?;
        let held = motion.path.pieces().last().filter(|piece| piece.regime == Regime::Stuck);
        if let Some(held) = held {
            let half_swings =
                motion.turns.iter().filter(|turn| turn.t > 0.0 && turn.t <= held.start).count();
            let stop = TurningPoint { t: held.start, x: motion.end_x };
            return Ok((stop, half_swings));
        }
        duration *= 2.0;
    }
}

pub(super) fn near_rest(alpha: f64, amplitude: f64) -> Result<NearRest, FrictionError> {
    let (stop, half_swings) = final_stop(alpha, amplitude)?;
    let creep = creep(alpha, stop.x)?;
    let until = (stop.t + (8.0 / creep.rate_linear).min(40.0)).max(TAU);
    let coulomb = swing(alpha, Friction::Exact, -amplitude, until)?;
    let arctangent = swing(alpha, Friction::Arctangent, -amplitude, until)?;
    let (x, velocity) = arctangent.path.phase_point_at(stop.t).unwrap_or((stop.x, 0.0));
    Ok(NearRest {
        stop,
        half_swings,
        meanwhile: [x, velocity],
        first_cycle: first_cycle(&arctangent),
        rest_times: rest_times(alpha, amplitude, stop.t, creep.motion.end_time)?,
        creep,
        motions: [coulomb, arctangent],
    })
}

fn first_cycle(motion: &Simulation) -> FirstCycle {
    const POINTS: usize = 40_000;
    let mut turns = motion.turns.iter().filter(|turn| turn.t > 0.0);
    let until = turns.nth(1).map_or(TAU.min(motion.end_time), |turn| turn.t);
    // The middles of equal times.
    let speeds: Vec<f64> = (0..POINTS)
        .filter_map(|index| {
            motion.path.phase_point_at(until * (index as f64 + 0.5) / POINTS as f64)
        })
        .map(|(_, velocity)| velocity.abs())
        .collect();
    let law = |speed: f64| FRAC_2_PI * (STEEPNESS * speed).atan();
    let part = |error: f64| {
        speeds.iter().filter(|speed| 1.0 - law(**speed) > error).count() as f64
            / speeds.len() as f64
    };
    let way: f64 = speeds.iter().sum();
    let work: f64 = speeds.iter().map(|speed| law(*speed) * speed).sum();
    let at_the_turn = motion.path.phase_point_at(until).map_or(0.0, |(_, velocity)| velocity.abs());
    let slowest = speeds.iter().copied().fold(at_the_turn, f64::min);
    FirstCycle {
        until,
        largest_error: 1.0 - law(slowest),
        over_one_percent: part(0.01),
        over_ten_percent: part(0.1),
        work_share: work / way,
        work_share_formula: work_share(speeds.iter().copied().fold(0.0, f64::max)),
    }
}

fn creep(alpha: f64, x: f64) -> Result<Creep, FrictionError> {
    let damping = alpha * FRAC_2_PI * STEEPNESS;
    let (creeps, rate_linear) = (damping > 2.0, slow_rate(damping));
    let duration = 10.0 / rate_linear;
    let motion = swing(alpha, Friction::Arctangent, x, duration)?;
    let at = |t: f64| motion.path.phase_point_at(t).map_or(f64::NAN, |(x, _)| x);
    // Eight times slower than the rate |100 x'| is small, and the motion is that of the linear
    // equation.
    let step = (0.5 / rate_linear).min(1.0);
    let rate =
        rate_of([0.0, 1.0, 2.0, 3.0].map(|number| at(8.0 / rate_linear + number * step)), step);
    let without_inertia = match creeps {
        true => Some(WithoutInertia::from_rest(alpha, x, duration)?),
        false => None,
    };
    let samples = [0.0, 0.5, 1.0, 2.0, 4.0, 8.0].map(|part| part / rate_linear);
    Ok(Creep {
        damping,
        creeps,
        rate_overdamped: creeps.then_some(1.0 / damping),
        rate_linear,
        rate,
        samples: samples
            .map(|t| CreepSample {
                t,
                x: at(t),
                formula: without_inertia.as_ref().and_then(|creep| creep.position_at(t)),
            })
            .into(),
        without_inertia,
        motion,
    })
}

/// The rate at which a linear motion dies, from four places at equal distances of time: the slow
/// one of two, or that of both where it swings; `None` if there is no motion. (R. Prony, 1795:
/// x_2 = p x_1 + q x_0, and z^2 = p z + q for z = e^(-rate step).)
fn rate_of([x0, x1, x2, x3]: [f64; 4], step: f64) -> Option<f64> {
    let determinant = x1 * x1 - x0 * x2;
    let decay = match determinant.abs() < 1e-6 * x1 * x1 {
        // Only one exponential remains.
        true => x1 / x0,
        false => {
            let (p, q) = ((x1 * x2 - x0 * x3) / determinant, (x1 * x3 - x2 * x2) / determinant);
            match 0.25 * p * p + q {
                square if square > 0.0 => 0.5 * p + square.sqrt(),
                _ => (-q).sqrt(),
            }
        }
    };
    Some(-decay.ln() / step).filter(|rate| rate.is_finite())
}

/// The creep without inertia: alpha (2/pi) atan(100 x') = -sin x, where friction balances the
/// weight.
#[derive(Debug, Clone)]
struct WithoutInertia {
    alpha: f64,
    /// The side of zero, 1 or -1.
    side: f64,
    /// log y, y = sin(pi |sin x|/(2 alpha)), which falls at the rate pi cos(x)/(200 alpha).
    logarithm: Trajectory<Point<[f64; 1]>>,
}

impl WithoutInertia {
    /// Follows the creep from rest at a position at which friction holds, |sin x| <= alpha.
    fn from_rest(alpha: f64, x: f64, duration: f64) -> Result<Self, FrictionError> {
        const TOLERANCE: f64 = 1e-10;
        let rate = 0.5 * PI / (STEEPNESS * alpha);
        let start = Point { t: 0.0, y: [(0.5 * PI * (x.abs().sin() / alpha).min(1.0)).sin().ln()] };
        let falls = move |_: f64, [log]: &[f64; 1], rates: &mut [f64; 1]| {
            *rates = [-rate * creep_position(alpha, *log).cos()]
        };
        let options = IntegrationOptions::with_tolerance(TOLERANCE);
        let logarithm = integrate_first_order(falls, start, duration, &[], &options);
        Ok(Self {
            alpha,
            side: x.signum(),
            logarithm: logarithm.map_err(|_| FrictionError::Restless(alpha))?,
        })
    }

    /// The place after this time, rad.
    fn position_at(&self, t: f64) -> Option<f64> {
        let [log] = self.logarithm.state_at(t)?.y;
        Some(self.side * creep_position(self.alpha, log))
    }
}

/// |x| of the creep without inertia from log y.
fn creep_position(alpha: f64, log: f64) -> f64 {
    (FRAC_2_PI * alpha * log.exp().min(1.0).asin()).asin()
}

/// The rest times of the default damper; the duration is four times that of the swing without a
/// barrier, and by the arctangent longer by `creep`, the time of the creep to rest.
fn rest_times(
    alpha: f64,
    amplitude: f64,
    stop: f64,
    creep: f64,
) -> Result<RestTimes, FrictionError> {
    let rest = |friction, creep: f64| {
        let model = Model { alpha, friction, ..Model::default() };
        Ok::<_, FrictionError>(
            followed(&model, -amplitude, (4.0 * stop).max(50.0) + creep)?.rest().time,
        )
    };
    Ok(RestTimes {
        coulomb: rest(Friction::Exact, 0.0)?,
        arctangent: rest(Friction::Arctangent, creep)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slow_rate_of_a_linear_motion_is_found() {
        let places = |motion: fn(f64) -> f64| [8.0, 8.5, 9.0, 9.5].map(motion);
        for (found, rate) in [
            (rate_of(places(|t| 2.0 * (-0.3 * t).exp()), 0.5), 0.3),
            (rate_of(places(|t| (-0.9 * t).exp() - 3.0 * (-1.1 * t).exp()), 0.5), 0.9),
            (rate_of(places(|t| (-0.4 * t).exp() * (0.9 * t).cos()), 0.5), 0.4),
        ] {
            assert!((found.unwrap() / rate - 1.0).abs() < 1e-9, "{found:?} {rate}");
        }
        assert_eq!(rate_of([0.0; 4], 0.5), None);
    }

    /// The average of averaging, by the rule of the middle.
    #[test]
    fn the_share_of_the_work_is_its_integral() {
        for speed in [1e-4, 0.01, 0.3, 2.0] {
            let count = 20_000;
            let term = |index: i32| {
                let sine = (PI * (f64::from(index) + 0.5) / f64::from(count)).sin();
                FRAC_2_PI * (STEEPNESS * speed * sine).atan() * sine
            };
            let integral: f64 = (0..count).map(term).sum::<f64>() * PI / f64::from(count) / 2.0;
            assert!((work_share(speed) / integral - 1.0).abs() < 1e-6, "{speed}");
        }
    }

    /// The formula of the creep solves its equation, alpha (2/pi) atan(100 x') = -sin x, also from
    /// beyond |x| = alpha.
    #[test]
    fn the_creep_solves_its_equation() {
        for (alpha, start) in [(0.3, 0.2), (0.95, -1.058), (0.8, -0.479), (0.5, 0.5_f64.asin())] {
            let creep = WithoutInertia::from_rest(alpha, start, 100.0).expect("a creep");
            let at = |t: f64| creep.position_at(t).expect("a place");
            assert!((at(0.0) - start).abs() < 1e-13, "{alpha}: {}", at(0.0));
            let step = 1e-3;
            for t in [0.5, 5.0, 40.0] {
                let velocity = (at(t + step) - at(t - step)) / (2.0 * step);
                let force = alpha * FRAC_2_PI * (STEEPNESS * velocity).atan();
                assert!(
                    (force + at(t).sin()).abs() < 1e-6,
                    "{alpha}, {t}: {force} {}",
                    at(t).sin()
                );
            }
        }
    }
}

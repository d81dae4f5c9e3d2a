//! The true motion of an impact, and the deviation of the closed form from it.
//!
//! In: the original equation x'' + f(x) + gamma F(x - x_c) H(x - x_c) = 0 as closures, released at
//! rest from x = -A; with contact damping gamma F (1 + lambda x') stands for gamma F, as long as
//! that pushes, or gamma (F + F(1) lambda x') with a dashpot. Out: [`TrueImpact`]: speed, depth, duration and period measured on the Runge-Kutta
//! path, the path, the drift of its energy
//!
//! ```text
//! x'^2/2 + V(x) + gamma int_0^depth F,      V' = f
//! ```
//!
//! Flight and contact are separate runs joined at the located touch; the flight back mirrors the
//! approach where nothing is lost, and is a run of its own where the contact is damped; then the
//! energy of the flights alone is watched. The closed form is not used: no frequency law, no line.

use super::Coordinate;
use crate::impact::collision::{Collision, CollisionError};
use crate::impact::error::ImpactError;
use crate::impact::linearisation::{greatest_depth, work};
use crate::impact::phases::ThreePhases;
use crate::numeric::ode::quadrature::{QuadratureError, integrate_smooth};
use crate::numeric::ode::{self, Event, StopReason, Trajectory, integrate};

/// The true motion of one impact, from release to the next turning point.
#[derive(Debug, Clone)]
pub struct TrueImpact {
    /// First touch: time, x_c, speed; here and below in the units of the equation.
    pub touch: ode::State,
    /// The deepest point.
    pub deepest: ode::State,
    /// The end of the contact.
    pub exit: ode::State,
    /// Greatest depth.
    pub penetration: f64,
    /// Duration of the contact.
    pub duration: f64,
    /// Time from the release to the turning point after the impact: the period, if no energy is
    /// lost.
    pub period: f64,
    /// The path from the release to the touch, counted from the release; run backwards it is that
    /// from the exit to the return.
    pub approach: Trajectory,
    /// The path in contact: depth and speed against the time since the touch.
    pub contact: Trajectory,
    /// The path from the exit to the turning point after it, place against the barrier and speed
    /// out of it against the time since the exit; `None` if it is the approach run backwards.
    pub back: Option<Trajectory>,
    /// Largest change of the energy along the path, in flight alone where the contact is damped,
    /// relative to the kinetic energy at touch: a measure of the accuracy of the path.
    pub energy_drift: f64,
}

/// Largest distance |x of the closed form - x of the true motion|, in the units of x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// In real time, within the true approach, contact and return.
    pub phases: [f64; 3],
    /// In real time, over one true period.
    pub total: f64,
    /// With each phase's clock started at its own start, in approach, contact and return: what is
    /// left when the error in the times of the joins is taken out.
    pub aligned: [f64; 3],
}

/// The message for a run that stopped early, with advice for the problem file.
pub(in crate::impact) fn way_forward(reason: &StopReason) -> String {
    match reason {
        StopReason::MaximumSteps { time } => {
            format!(
                "the allowed number of steps was used up at t = {time}: raise step_limit in [run]"
            )
        }
        StopReason::EndReached => format!("it is still under way at t = {LONGEST_TIME}"),
        reason => reason.to_string(),
    }
}

/// Follows the motion from its release until the barrier lets it go again. Without damping it
/// leaves with the same speed: the flight back is the approach run backwards, so the period has as
/// many digits as the approach, also if the release is near the upright position, where its energy
/// is lost in rounding. A damped contact is followed by a flight of its own to where it turns.
///
/// The contact is counted from the touch, in depth and in time, so a hard barrier costs no digits.
/// No step may err by more than the relative tolerance at the amplitude or at the depth, however
/// large the absolute one is.
///
/// # Errors
/// [`ImpactError`]: the barrier is not reached, or the run ends early.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{Collision, hertz::elastic_force, true_impact};
/// use lindstedt::numeric::ode::IntegrationOptions;
///
/// let pendulum = Collision {
///     release: -1.5,
///     barrier: 0.323,
///     stiffness: 1e6,
///     restoring_force: &f64::sin,
///     elastic_force: &elastic_force,
///     damping: 0.0,
///     dashpot: None,
/// };
/// let truth = true_impact(&pendulum, &IntegrationOptions::with_tolerance(1e-12))?;
/// let by_energy = (2.0 * (0.323_f64.cos() - 1.5_f64.cos())).sqrt();
/// assert!((truth.touch.v - by_energy).abs() < 1e-10 && truth.energy_drift < 1e-9);
/// # Ok::<(), lindstedt::impact::ImpactError>(())
/// ```
pub fn true_impact(
    collision: &Collision,
    options: &ode::IntegrationOptions,
) -> Result<TrueImpact, ImpactError> {
    let &Collision { release, barrier, stiffness, restoring_force, elastic_force, damping, .. } =
        collision;
    if barrier <= release {
        return Err(CollisionError::ReleasedBehindBarrier { release, barrier }.into());
    }
    let scale = release.abs();
    let swing = |_: f64, x: f64, _: f64| -restoring_force(x);
    let press = |depth: f64, inwards: f64| collision.contact_force(depth, inwards);
    let approach = approach(swing, [release, barrier], &at_scale(options, scale))?;
    let touch = ode::State { x: barrier, ..approach.end() };
    let energy = 0.5 * touch.v * touch.v;
    // A barrier that is soft for this swing lets it through to the other side.
    let size =
        greatest_depth(elastic_force, energy / stiffness).map_or(scale, |depth| depth.min(scale));
    let touched = ode::State { t: 0.0, x: 0.0, v: touch.v };
    let inside = Coordinate { sign: 1.0, origin: barrier };
    let events = [
        Event::stop(|_: f64, depth: f64, _: f64| depth).falling(),
        Event::record(|_: f64, _: f64, v: f64| v).falling(),
    ];
    let contact = integrate(
        inside.contact(swing, press),
        touched,
        LONGEST_TIME,
        &events,
        &at_scale(options, size),
    )?;
    let StopReason::Event { .. } = contact.stop_reason() else {
        return Err(ImpactError::Stopped(contact.stop_reason()));
    };
    let turn = contact.occurrences().iter().find(|found| found.event == 1);
    // In a graze too shallow for doubles to resolve a turning point, touch, turn and exit coincide.
    let deepest = turn.map_or(touched, |found| found.state);
    let exit = contact.end();
    let seen =
        |state: ode::State| ode::State { t: touch.t + state.t, x: inside.x(state.x), v: state.v };
    let back = match damping > 0.0 {
        true => Some(way_back(swing, barrier, exit, &at_scale(options, scale))?),
        false => None,
    };
    let energy_drift = energy_drift(collision, &approach, &contact, back.as_ref())?;
    Ok(TrueImpact {
        touch,
        deepest: seen(deepest),
        exit: ode::State { x: barrier, ..seen(exit) },
        penetration: deepest.x,
        duration: exit.t,
        period: touch.t + exit.t + back.as_ref().map_or(touch.t, |back| back.end().t),
        approach,
        contact,
        back,
        energy_drift,
    })
}

/// The largest change of the energy along a motion, over that of the release; a contact that loses
/// energy is left out, but not the way back.
fn energy_drift(
    collision: &Collision,
    approach: &Trajectory,
    contact: &Trajectory,
    back: Option<&Trajectory>,
) -> Result<f64, ImpactError> {
    let &Collision { release, barrier, stiffness, restoring_force, elastic_force, .. } = collision;
    // Counted from the barrier: the energy at release is the kinetic energy at touch.
    let potential = |to: f64| {
        integrate_smooth(restoring_force, barrier, to, 1e-13).map(|(integral, _)| integral)
    };
    let released = potential(release)?;
    let exit = contact.end();
    let flight = largest_change(approach, released, |gone| potential(release + gone))?;
    let rest = match back {
        None => largest_change(contact, released, |depth| {
            Ok(potential(barrier + depth)? + stiffness * work(elastic_force, depth)?)
        })?,
        Some(back) => {
            largest_change(back, 0.5 * exit.v * exit.v, |gone| potential(barrier - gone))?
        }
    };
    Ok(flight.max(rest) / released.abs())
}

/// The options with an absolute tolerance in proportion to this size.
fn at_scale(options: &ode::IntegrationOptions, size: f64) -> ode::IntegrationOptions {
    ode::IntegrationOptions {
        absolute_tolerance: options
            .absolute_tolerance
            .min(options.relative_tolerance * size)
            .max(f64::MIN_POSITIVE),
        ..*options
    }
}

/// The flight from rest to the touch.
fn approach(
    swing: impl Fn(f64, f64, f64) -> f64,
    [release, barrier]: [f64; 2],
    options: &ode::IntegrationOptions,
) -> Result<Trajectory, ImpactError> {
    // Counted from the release: near the top of the swing every digit of the distance to it
    // matters.
    let released = Coordinate { sign: 1.0, origin: release };
    let way = barrier - release;
    let start = ode::State { t: 0.0, x: 0.0, v: 0.0 };
    let events = [
        Event::stop(|_: f64, gone: f64, _: f64| gone - way).rising(),
        Event::stop(|_: f64, _: f64, v: f64| v).falling(),
    ];
    let approach = integrate(released.flight(swing), start, LONGEST_TIME, &events, options)?;
    match approach.stop_reason() {
        StopReason::Event { event: 0, .. } => Ok(approach),
        StopReason::Event { .. } => Err(CollisionError::NeverReaches {
            release,
            furthest: released.x(approach.end().x),
            barrier,
        }
        .into()),
        reason => Err(ImpactError::Stopped(reason)),
    }
}

/// The flight from the exit to where it turns, counted from the barrier outwards.
fn way_back(
    swing: impl Fn(f64, f64, f64) -> f64,
    barrier: f64,
    exit: ode::State,
    options: &ode::IntegrationOptions,
) -> Result<Trajectory, ImpactError> {
    let outwards = Coordinate { sign: -1.0, origin: barrier };
    let start = ode::State { t: 0.0, x: 0.0, v: -exit.v };
    let events = [Event::stop(|_: f64, _: f64, v: f64| v).falling()];
    let back = integrate(outwards.flight(swing), start, LONGEST_TIME, &events, options)?;
    match back.stop_reason() {
        StopReason::Event { .. } => Ok(back),
        reason => Err(ImpactError::Stopped(reason)),
    }
}

/// Largest difference from this energy along a path; `held` is the potential energy at a position.
fn largest_change(
    path: &Trajectory,
    energy: f64,
    held: impl Fn(f64) -> Result<f64, QuadratureError>,
) -> Result<f64, QuadratureError> {
    let mut change = 0.0_f64;
    for knot in path.knots() {
        change = change.max((0.5 * knot.v * knot.v + held(knot.x)? - energy).abs());
    }
    Ok(change)
}

/// A time longer than any impact of interest; the number of steps is the effective limit.
const LONGEST_TIME: f64 = 1e9;

/// The most that the quantities of an impact may change, relative to each, between a tolerance and
/// one a hundred times closer. Errors go with the tolerance: the remaining error is about a
/// hundredth of the change, and six digits are printed.
const ACCURACY: f64 = 5e-5;

/// The tightest tolerance worth trying in double precision.
const TIGHTEST: f64 = 1e-14;

/// The true impact with assured digits: a tolerance a hundred times looser changes no quantity by
/// more than 5e-5 of itself. The first pair compared is that of `options` and a hundredth of it; if
/// they differ the next one is tighter.
///
/// # Errors
/// As [`true_impact`], and [`ImpactError::NotSettled`] if double precision does not give six
/// digits.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{Collision, assured_impact, hertz::elastic_force};
/// use lindstedt::numeric::ode::IntegrationOptions;
///
/// let pendulum = Collision {
///     release: -1.5,
///     barrier: 0.323,
///     stiffness: 1e6,
///     restoring_force: &f64::sin,
///     elastic_force: &elastic_force,
///     damping: 0.0,
///     dashpot: None,
/// };
/// let truth = assured_impact(&pendulum, &IntegrationOptions::default())?;
/// assert!((truth.penetration / 0.005446775 - 1.0).abs() < 1e-6); // rad
/// # Ok::<(), lindstedt::impact::ImpactError>(())
/// ```
pub fn assured_impact(
    collision: &Collision,
    options: &ode::IntegrationOptions,
) -> Result<TrueImpact, ImpactError> {
    let with = |tolerance: f64| {
        let options = ode::IntegrationOptions {
            relative_tolerance: tolerance,
            absolute_tolerance: tolerance,
            ..*options
        };
        true_impact(collision, &options)
    };
    let mut tolerance = options.relative_tolerance;
    let mut motion = with(tolerance)?;
    loop {
        let closer = 0.01 * tolerance;
        let is_last = closer < TIGHTEST;
        let other = with(if is_last { 100.0 * tolerance } else { closer })?;
        let known = |motion: &TrueImpact| motion.quantities().into_iter().chain([motion.exit.v]);
        let change = known(&motion)
            .zip(known(&other))
            .map(|(one, other)| (one / other - 1.0).abs())
            .fold(0.0, f64::max);
        if change <= ACCURACY {
            return Ok(if is_last { motion } else { other });
        }
        if is_last {
            return Err(ImpactError::NotSettled { change });
        }
        (tolerance, motion) = (closer, other);
    }
}

impl TrueImpact {
    /// Time to contact, speed, penetration, duration, period: in the order of
    /// [`ThreePhases::quantities`].
    pub fn quantities(&self) -> [f64; 5] {
        [self.touch.t, self.touch.v, self.penetration, self.duration, self.period]
    }

    /// Exit speed over entry speed: 1 if no energy is lost.
    pub fn restitution(&self) -> f64 {
        -self.exit.v / self.touch.v
    }

    /// Displacement and velocity at a time between release and return, limited to that interval.
    pub fn phase_point_at(&self, t: f64) -> (f64, f64) {
        let barrier = self.touch.x;
        let t = t.clamp(0.0, self.period);
        if t < self.touch.t {
            return self.flight(t);
        }
        if t < self.exit.t {
            let (depth, v) =
                self.contact.phase_point_at(t - self.touch.t).unwrap_or((0.0, self.exit.v));
            return (barrier + depth, v);
        }
        if let Some(back) = &self.back {
            let end = back.end();
            let (gone, v) = back.phase_point_at(t - self.exit.t).unwrap_or((end.x, end.v));
            return (barrier - gone, -v);
        }
        let (x, v) = self.flight(self.period - t);
        (x, -v)
    }

    /// Displacement and velocity on the approach.
    fn flight(&self, t: f64) -> (f64, f64) {
        let way = self.approach.end().x;
        match self.approach.phase_point_at(t) {
            Some((gone, v)) => (self.touch.x - (way - gone), v),
            None => (self.touch.x, self.touch.v),
        }
    }
}

/// The deviation of the closed form from the true motion.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{PhaseReading, Setup, deviation, solve};
///
/// let impact = solve(Setup { stiffness: 1e6, ..Setup::default() })?;
/// let derived = impact.column(PhaseReading::Derived).ok_or("none")?;
/// assert_eq!(deviation(&derived.phases, &impact.truth), derived.deviation);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn deviation(closed_form: &ThreePhases, truth: &TrueImpact) -> Deviation {
    let true_limits = [0.0, truth.touch.t, truth.exit.t, truth.period];
    let true_position = |t: f64| truth.phase_point_at(t).0;
    let mut phases = [0.0; 3];
    let mut aligned = [0.0; 3];
    for (index, phase) in closed_form.phases.iter().enumerate() {
        let (from, to) = (true_limits[index], true_limits[index + 1]);
        phases[index] = largest(from, to, |t| closed_form.position_at(t) - true_position(t));
        // The comparison covers the time that both phases have in common.
        let common = (to - from).min(phase.end - phase.start);
        aligned[index] = largest(0.0, common, |elapsed| {
            phase.phase_point_at(phase.start + elapsed).0 - true_position(from + elapsed)
        });
    }
    // The short contact of the closed form may lie within another true phase, where it needs a grid
    // of its own.
    let contact = &closed_form.phases[1];
    let inside = |t: f64| (0.0..=truth.period).contains(&t);
    let missed = largest(contact.start, contact.end, |t| {
        if inside(t) { closed_form.position_at(t) - true_position(t) } else { 0.0 }
    });
    let total = phases.iter().copied().fold(missed, f64::max);
    Deviation { phases, total, aligned }
}

/// Largest |function| on a grid: enough points that a smooth maximum is right to six digits.
fn largest(from: f64, to: f64, function: impl Fn(f64) -> f64) -> f64 {
    let points = 2000;
    let values = (0..=points)
        .map(|index| function(from + (to - from) * f64::from(index) / f64::from(points)).abs());
    // A value that is not a number must not be passed over.
    values.fold(
        0.0,
        |worst: f64, value| {
            if value > worst || value.is_nan() { value } else { worst }
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::error::ImpactError;
    use crate::impact::hertz::{StiffnessDesign, elastic_force};
    use crate::impact::linearisation::Rule;
    use crate::impact::phases::{ContactSpeed, ImpactProblem, three_phases};
    use crate::numeric::ode::IntegrationOptions;
    use crate::numeric::ode::root::find_root;

    const FORCE: fn(f64) -> f64 = f64::sin;

    fn swing(barrier: f64, stiffness: f64) -> ImpactProblem<'static> {
        ImpactProblem {
            amplitude: 1.5,
            barrier,
            stiffness,
            frequency_squared: 1.0 - 1.5 * 1.5 / 8.0,
            linear_stiffness: 1.0,
            restoring_force: &FORCE,
            elastic_force: &elastic_force,
            rule: Rule::LeastSquares,
        }
    }

    fn collision(amplitude: f64, barrier: f64, stiffness: f64) -> Collision<'static> {
        Collision {
            release: -amplitude,
            barrier,
            stiffness,
            restoring_force: &FORCE,
            elastic_force: &elastic_force,
            damping: 0.0,
            dashpot: None,
        }
    }

    fn pendulum(barrier: f64, stiffness: f64) -> TrueImpact {
        true_impact(&collision(1.5, barrier, stiffness), &IntegrationOptions::with_tolerance(1e-13))
            .unwrap()
    }

    fn near(value: f64, expected: f64, allowed: f64) {
        assert!((value - expected).abs() <= allowed, "{value} against {expected}");
    }

    /// Depth and duration of the contact from the energy alone: depth = q^2, v^2 = v0^2 - 2 (cos
    /// x_c - cos(x_c + q^2)) - (4/5) gamma q^5 = (q_m - q) H, T_c = 8 sqrt(q_m) int_0^1 q/sqrt(H)
    /// dw.
    fn contact_by_quadrature(barrier: f64, stiffness: f64) -> (f64, f64) {
        let square =
            |q: f64| 2.0 * ((barrier + q * q).cos() - 1.5_f64.cos()) - 0.8 * stiffness * q.powi(5);
        let deepest = find_root(square, 0.0, 1.0).unwrap();
        let slope = |q: f64| 4.0 * q * (barrier + q * q).sin() + 4.0 * stiffness * q.powi(4);
        let quotient = |q: f64| {
            integrate_smooth(|part| slope(q + part * (deepest - q)), 0.0, 1.0, 1e-14).unwrap().0
        };
        let integrand = |w: f64| {
            let q = deepest * (1.0 - w * w);
            q / quotient(q).sqrt()
        };
        let duration =
            8.0 * deepest.sqrt() * integrate_smooth(integrand, 0.0, 1.0, 1e-13).unwrap().0;
        (deepest * deepest, duration)
    }

    #[test]
    fn speed_depth_and_times_are_those_of_the_energy() {
        let m = 0.75_f64.sin().powi(2);
        for (barrier, stiffness) in
            [(0.323, 1e6), (0.323, 3.0407e7), (0.0, 1e4), (-0.7, 1e5), (1.2, 1e8)]
        {
            let truth = pendulum(barrier, stiffness);
            near(truth.touch.v, (2.0 * (barrier.cos() - 1.5_f64.cos())).sqrt(), 1e-11);
            near(truth.touch.v, collision(1.5, barrier, stiffness).contact_speed().unwrap(), 1e-11);
            near(truth.exit.v, -truth.touch.v, 2e-11);
            let reached = (0.5 * barrier).sin() / 0.75_f64.sin();
            let approach = ellip::ellipk(m).unwrap() + ellip::ellipf(reached.asin(), m).unwrap();
            near(truth.touch.t, approach, 2e-12);
            let (depth, duration) = contact_by_quadrature(barrier, stiffness);
            near(truth.penetration, depth, 1e-12);
            near(truth.duration, duration, 2e-12);
            near(truth.period, 2.0 * approach + duration, 1e-11);
            near(truth.phase_point_at(truth.period).0, -1.5, 1e-11);
            assert!(truth.energy_drift < 1e-10, "drift {}", truth.energy_drift);
        }
    }

    #[test]
    fn the_swing_of_the_paper_to_all_digits_known() {
        let truth = pendulum(0.323, 1e6);
        near(truth.touch.v, 1.324_802_058_11, 1e-11);
        near(truth.touch.t, 2.064_407_608_58, 1e-11);
        near(truth.penetration, 0.005_446_774_934_46, 1e-13);
        near(truth.duration, 0.012_106_027_06, 1e-11);
    }

    #[test]
    fn the_drift_tells_a_loose_run_from_a_tight_one() {
        let run = |tolerance| {
            let options = IntegrationOptions::with_tolerance(tolerance);
            true_impact(&collision(1.5, 0.323, 1e6), &options).unwrap().energy_drift
        };
        assert!(run(1e-5) > 1e3 * run(1e-11));
    }

    #[test]
    fn the_closed_form_beside_the_true_motion() {
        let stiffness = StiffnessDesign::default().stiffness().unwrap();
        let truth = pendulum(0.323, stiffness);
        for column in [ContactSpeed::Paper, ContactSpeed::Energy] {
            let motion = three_phases(&swing(0.323, stiffness), column).unwrap();
            let found = deviation(&motion, &truth);
            // The touch comes 0.044 late, so after the true one the paths part at twice the speed
            // times that delay.
            let delay = motion.phases[0].end - truth.touch.t;
            near(delay, 2.108_808_612 - 2.064_407_608_58, 1e-9);
            assert!(
                found.phases[0] > 0.9 * delay * motion.speed && found.phases[0] < 0.1,
                "{found:?}"
            );
            near(found.total, 2.0 * delay * truth.touch.v, 0.3 * delay);
            // With the clock of the contact set right, what is left is a part of the depth
            // of 1.4e-3.
            assert!(found.aligned[1] < 0.15 * truth.penetration, "{found:?}");
        }
        let of = |column| {
            deviation(&three_phases(&swing(0.323, stiffness), column).unwrap(), &truth).aligned[1]
        };
        assert!(
            of(ContactSpeed::Energy) < 0.7 * of(ContactSpeed::Paper),
            "the right speed brings the contact closer"
        );
        let energy = three_phases(&swing(0.323, stiffness), ContactSpeed::Energy).unwrap();
        near(energy.duration / truth.duration, 1.016, 2e-3);
        near(energy.penetration / truth.penetration, 1.0, 1e-3);
    }

    #[test]
    fn a_motion_compared_with_itself_does_not_deviate() {
        // A linear pendulum and a linear barrier: the closed form is exact but for gravity in the
        // contact, 0 at x_c = 0 where the spring k = 1 acts from.
        let spring = |depth: f64| depth;
        let linear = |x: f64| x;
        let exact = ImpactProblem {
            frequency_squared: 1.0,
            restoring_force: &linear,
            elastic_force: &spring,
            ..swing(0.4, 1e4)
        };
        let truth =
            true_impact(&exact.collision(), &IntegrationOptions::with_tolerance(1e-13)).unwrap();
        for column in [ContactSpeed::Paper, ContactSpeed::Energy] {
            let motion = three_phases(&exact, column).unwrap();
            let found = deviation(&motion, &truth);
            assert!(
                found.total < 1e-10 && found.aligned.iter().all(|part| *part < 1e-10),
                "{found:?}"
            );
            near(motion.period, truth.period, 1e-10);
        }
    }

    #[test]
    fn what_cannot_be_followed_is_refused() {
        let run = |amplitude, barrier| {
            true_impact(&collision(amplitude, barrier, 1e6), &IntegrationOptions::default())
                .unwrap_err()
        };
        let refused = run(0.3, 0.323);
        assert!(
            matches!(refused, ImpactError::Collision(CollisionError::NeverReaches { furthest, .. }) if (furthest - 0.3).abs() < 1e-8),
            "{refused}"
        );
        assert!(matches!(
            run(1.5, -1.5),
            ImpactError::Collision(CollisionError::ReleasedBehindBarrier { .. })
        ));
        assert!(matches!(run(f64::NAN, 0.3), ImpactError::Integration(_)));
        let few = IntegrationOptions { maximum_steps: 5, ..IntegrationOptions::default() };
        let refused = true_impact(&collision(1.5, 0.323, 1e6), &few).unwrap_err();
        assert!(
            matches!(refused, ImpactError::Stopped(StopReason::MaximumSteps { .. })),
            "{refused}"
        );
        // At rest on top: it never gets anywhere.
        let still = Collision { restoring_force: &|_| 0.0, ..collision(1.0, 0.3, 1.0) };
        let refused = true_impact(&still, &IntegrationOptions::default()).unwrap_err();
        assert!(matches!(refused, ImpactError::Stopped(StopReason::EndReached)), "{refused}");
    }
}

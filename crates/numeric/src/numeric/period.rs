//! The true period, by methods that share no code with the formulas.
//!
//! Conservative motion: adaptive quadrature of the time per angle that
//! [`crate::numeric::ode::energy`] gives between the two turning points.
//!
//! Any other periodic motion: the return to a turning point, followed by a Runge-Kutta method.
//!
//! Only the judge (`mod@crate::verify`) may use this file; `tests/library/layers.rs` checks it.

pub use crate::numeric::ode::energy::{PeriodError, PiecewiseForce, turning_point};

use crate::numeric::ode::energy::TimePerAngle;
use crate::numeric::ode::quadrature::{QuadratureError, integrate_smooth};
use crate::numeric::ode::{Event, IntegrationOptions, State, StopReason, Trajectory, integrate};

/// Tolerance per step of the Runge-Kutta runs that find a return.
const STEP_TOLERANCE: f64 = 1e-13;

/// The period of `x'' + force(x) = 0` released at rest from `start`, swinging about `equilibrium`.
///
/// # Errors
/// See [`PeriodError`].
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::period::{PiecewiseForce, conservative_period};
///
/// let period = conservative_period(&PiecewiseForce::smooth(&f64::sin), 0.0, 1.5)?; // a pendulum, rad
/// assert!((std::f64::consts::TAU / period - 0.860_608_346_679_613).abs() < 1e-12);
/// # Ok::<(), lindstedt::numeric::period::PeriodError>(())
/// ```
pub fn conservative_period(
    force: &PiecewiseForce,
    equilibrium: f64,
    start: f64,
) -> Result<f64, PeriodError> {
    period_between(force, start, turning_point(force, equilibrium, start)?)
}

/// The period of the motion between two turning points.
///
/// # Errors
/// See [`PeriodError`].
pub fn period_between(force: &PiecewiseForce, start: f64, end: f64) -> Result<f64, PeriodError> {
    period_of_rates(&TimePerAngle::new(force, &|_| 1.0, start, end)?)
}

/// `T = 2 int (dt/dphi) dphi`, piece by piece.
fn period_of_rates(rates: &TimePerAngle) -> Result<f64, PeriodError> {
    let (mut half, mut estimate) = (0.0, 0.0);
    for piece in 0..rates.angles.len() - 1 {
        let mut failure = None;
        let integrand = |variable: f64| {
            let (phi, slope) = rates.angle_at(piece, variable);
            match rates.time_per_angle(piece, phi) {
                Ok(value) => slope * value,
                Err(error) => {
                    failure = Some(error);
                    f64::NAN
                }
            }
        };
        let [from, to] = rates.variable_range(piece);
        match integrate_smooth(integrand, from, to, rates.tolerance(piece)) {
            Ok((value, error)) => (half, estimate) = (half + value, estimate + error),
            // Where the force is a small difference, as x^2 - 4 near x = 2, its own rounding limits
            // every panel: the best value is taken.
            Err(QuadratureError::NotConverged { value, error_estimate, .. }) => {
                (half, estimate) = (half + value, estimate + error_estimate)
            }
            Err(error) => return Err(failure.unwrap_or(error).into()),
        }
    }
    if estimate < 1e-9 * half {
        return Ok(2.0 * half);
    }
    Err(PeriodError::Quadrature(QuadratureError::NotConverged {
        value: half,
        error_estimate: estimate,
        worst_at: rates.knots[0],
    }))
}

/// A motion from one turning point to the next on the same side, in the units of the equation.
///
/// Runge-Kutta compares its errors with absolute numbers, so the path is kept in units of the
/// amplitude and of the time `sqrt(amplitude/acceleration)`.
#[derive(Clone, Debug)]
pub struct Swing {
    path: Trajectory,
    equilibrium: f64,
    length: f64,
    time: f64,
}

impl Swing {
    /// Returns the motion with `origin` added to all positions.
    #[must_use]
    pub fn moved(mut self, origin: f64) -> Self {
        self.equilibrium += origin;
        self
    }

    /// The time of the swing.
    pub fn period(&self) -> f64 {
        self.path.end().t * self.time
    }

    /// Position and velocity at a time from zero to the period; `None` before.
    pub fn phase_point_at(&self, t: f64) -> Option<(f64, f64)> {
        let (x, v) = self.path.phase_point_at((t / self.time).min(self.path.end().t))?;
        Some((self.equilibrium + self.length * x, self.length / self.time * v))
    }

    /// The turning point at the end.
    pub fn end(&self) -> State {
        let end = self.path.end();
        State {
            t: end.t * self.time,
            x: self.equilibrium + self.length * end.x,
            v: self.length / self.time * end.v,
        }
    }
}

/// One full swing by Runge-Kutta: from rest at `start` to the next turning point on the same side.
///
/// # Errors
/// See [`PeriodError`].
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::period::swing;
///
/// let swing = swing(&|_t, x, _v| -f64::sin(x), 0.0, 1.5, 20.0)?;
/// assert!((std::f64::consts::TAU / swing.period() - 0.860_608_346_679_613).abs() < 1e-9);
/// # Ok::<(), lindstedt::numeric::period::PeriodError>(())
/// ```
pub fn swing(
    acceleration: &dyn Fn(f64, f64, f64) -> f64,
    equilibrium: f64,
    start: f64,
    longest: f64,
) -> Result<Swing, PeriodError> {
    swing_with_cuts(acceleration, &[], equilibrium, start, longest)
}

/// Follows a swing as [`swing`] does, restarted at every cut, so that no step jumps over a corner
/// or a narrow part of the force.
///
/// # Errors
/// See [`PeriodError`].
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::period::swing_with_cuts;
///
/// // A ball that rolls down two slopes turns at its corner.
/// let swing = swing_with_cuts(&|_t, x, _v| -x.signum(), &[0.0], 0.0, 0.5, 10.0)?;
/// assert!((swing.period() - 4.0).abs() < 1e-9); // 4 sqrt(2 A)
/// # Ok::<(), lindstedt::numeric::period::PeriodError>(())
/// ```
pub fn swing_with_cuts(
    acceleration: &dyn Fn(f64, f64, f64) -> f64,
    cuts: &[f64],
    equilibrium: f64,
    start: f64,
    longest: f64,
) -> Result<Swing, PeriodError> {
    let length = (start - equilibrium).abs();
    let pull = acceleration(0.0, start, 0.0).abs();
    let time = match (length / pull).sqrt() {
        time if time.is_normal() => time,
        _ => 1.0,
    };
    let scaled = |t: f64, x: f64, v: f64| {
        time * (time / length * acceleration(time * t, equilibrium + length * x, length / time * v))
    };
    let state = State { t: 0.0, x: (start - equilibrium) / length, v: 0.0 };
    let turning = Event::stop(|_, _, v| v);
    let turning = if start > equilibrium { turning.falling() } else { turning.rising() };
    let at_cut = |cut: f64| {
        let cut = (cut - equilibrium) / length;
        Event::switch(move |_, x, _| x - cut, move |state: State| (0, State { x: cut, ..state }))
    };
    let events: Vec<Event> =
        std::iter::once(turning).chain(cuts.iter().map(|&cut| at_cut(cut))).collect();
    let path = integrate(
        scaled,
        state,
        longest / time,
        &events,
        &IntegrationOptions::with_tolerance(STEP_TOLERANCE),
    )?;
    let swing = Swing { path, equilibrium, length, time };
    match swing.path.stop_reason() {
        StopReason::Event { .. } => Ok(swing),
        StopReason::NonFinite { .. } | StopReason::StepTooSmall { .. } => {
            Err(ending(acceleration, equilibrium, start, swing.end()))
        }
        _ => Err(PeriodError::NoReturn(swing.end().t)),
    }
}

/// Returns the reason why a motion cannot be followed past a state: the force has no value there,
/// or the motion escapes or runs away.
fn ending(
    acceleration: &dyn Fn(f64, f64, f64) -> f64,
    equilibrium: f64,
    start: f64,
    state: State,
) -> PeriodError {
    /// Number of amplitudes beyond which a motion does not oscillate.
    const FAR: f64 = 1e6;
    /// Ratio of the force to that at rest beyond which it is the speed that drives the motion.
    const DRIVEN: f64 = 1e3;
    let length = (start - equilibrium).abs();
    let [moving, still] = [state.v, 0.0].map(|speed| acceleration(state.t, state.x, speed).abs());
    if (state.x - equilibrium).abs() > FAR * length {
        return PeriodError::Escapes { start, searched: state.x, range: None };
    }
    if still.is_finite() && (!moving.is_finite() || moving > DRIVEN * still) {
        let six_digits = format!("{:.5e}", state.t);
        return PeriodError::RunsAway { start, time: six_digits.parse().unwrap_or(state.t) };
    }
    let at_rest = (state.x - equilibrium).abs() < 1e-9 * length;
    PeriodError::Pole { place: if at_rest { equilibrium } else { state.x } }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn period_of(
        force: &dyn Fn(f64) -> f64,
        equilibrium: f64,
        start: f64,
    ) -> Result<f64, PeriodError> {
        conservative_period(&PiecewiseForce::smooth(force), equilibrium, start)
    }

    #[test]
    fn pendulum_and_duffing_by_elliptic_functions() {
        for amplitude in [0.01, 0.5, 1.5, 2.5, 3.0, 3.13, -1.5] {
            let period = period_of(&|x: f64| x.sin(), 0.0, amplitude).unwrap();
            // By the complementary parameter 1 - m = cos^2(A/2): near the separatrix m itself has
            // lost its digits.
            let exact = 4.0 * spec_math::cephes64::ellpk((0.5 * amplitude).cos().powi(2));
            assert!((period / exact - 1.0).abs() < 1e-13, "A = {amplitude}: {period} {exact}");
        }
        for s in [-0.9, 0.1, 1.0, 10.0, 1000.0] {
            let period = period_of(&|x: f64| x + s * x * x * x, 0.0, 1.0).unwrap();
            let exact = 4.0 * ellip::ellipk(s / (2.0 * (1.0 + s))).unwrap() / f64::sqrt(1.0 + s);
            assert!((period / exact - 1.0).abs() < 1e-13, "s = {s}: {period} {exact}");
        }
    }

    /// For a force sgn(x) |x|^p and n = p + 1 the period of amplitude 1 is
    /// `4 sqrt(n/2) sqrt(pi) Gamma(1 + 1/n)/Gamma(1/2 + 1/n)`.
    #[test]
    fn a_root_of_the_position_takes_few_values_of_the_force() {
        let cases = [
            // Gamma(7/4)/Gamma(5/4), Gamma(5/3)/Gamma(7/6).
            (1.0 / 3.0, 0.919_062_526_848_883_2 / 0.906_402_477_055_477),
            (0.5, 0.902_745_292_950_933_6 / 0.927_719_333_630_039_2),
        ];
        for (power, gammas) in cases {
            let exact = 4.0 * (0.5 * (power + 1.0) * std::f64::consts::PI).sqrt() * gammas;
            let calls = std::cell::Cell::new(0);
            let force = |x: f64| {
                calls.set(calls.get() + 1);
                x.abs().powf(power).copysign(x)
            };
            // The corner is a cut, at zero and elsewhere.
            for middle in [0.0, 0.25] {
                let cuts = |from: f64, to: f64| {
                    [middle].into_iter().filter(|cut| from < *cut && *cut < to).collect()
                };
                calls.set(0);
                let moved = |x: f64| force(x - middle);
                let moved = PiecewiseForce::with_cuts(&moved, &cuts);
                let period = conservative_period(&moved, middle, middle + 1.0).unwrap();
                assert!((period / exact - 1.0).abs() < 1e-12, "{power}: {period} {exact}");
                assert!(calls.get() < 1500, "{power}: {}", calls.get());
            }
        }
    }

    #[test]
    fn an_uneven_well_has_its_own_turning_point() {
        // V = x^2/2 + x^3/3 at x = 1/4: V(x_1) = V(1/4) is a cubic with root 1/4, leaving a
        // quadratic.
        let end = turning_point(&PiecewiseForce::smooth(&|x: f64| x + x * x), 0.0, 0.25).unwrap();
        let quadratic = |x: f64| x * x + 1.75 * x + 0.4375;
        assert!(quadratic(end).abs() < 1e-15, "{end}");
        let period = period_of(&|x: f64| x + x * x, 0.0, 0.25).unwrap();
        let swing = swing(&|_, x, _| -x - x * x, 0.0, 0.25, 100.0).unwrap();
        assert!((period - swing.end().t).abs() < 1e-10);
    }

    #[test]
    fn a_force_that_is_a_small_difference_is_good_to_its_rounding() {
        for amplitude in [0.3, 0.01, 1e-3] {
            let shifted = period_of(&|x: f64| x * x - 4.0, 2.0, 2.0 + amplitude).unwrap();
            let direct = period_of(&|d: f64| 4.0 * d + d * d, 0.0, amplitude).unwrap();
            assert!(
                (shifted / direct - 1.0).abs() < 1e-13 / amplitude,
                "{amplitude}: {shifted} {direct}"
            );
        }
    }

    #[test]
    fn what_does_not_swing_is_refused() {
        let cubic = |x: f64| x - x * x * x / 6.0;
        assert!(matches!(period_of(&cubic, 0.0, 2.5), Err(PeriodError::PushedAway { .. })));
        assert!(matches!(
            period_of(&|x: f64| x + x * x, 0.0, 0.75),
            Err(PeriodError::Escapes { .. })
        ));
    }

    #[test]
    fn a_motion_in_another_well_is_told_from_one_over_all() {
        let wells = |x: f64| x - x.powi(3) + 0.2 * x.powi(5);
        assert!(matches!(
            conservative_period(&PiecewiseForce::smooth(&wells), 0.0, 2.0),
            Err(PeriodError::OtherWell { .. })
        ));
        assert!(
            (turning_point(&PiecewiseForce::smooth(&wells), 0.0, 2.5).unwrap() + 2.5).abs() < 1e-14
        );
        let uneven = |x: f64| wells(x) + 0.01;
        assert!(matches!(
            conservative_period(&PiecewiseForce::smooth(&uneven), -0.01, -2.0),
            Err(PeriodError::OtherWell { .. })
        ));
    }
}

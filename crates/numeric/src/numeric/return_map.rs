//! True limit cycles: fixed points of the return map, in the direction of time in which they
//! attract.
//!
//! Reference: A. A. Andronov, A. A. Vitt and S. E. Khaikin, *Theory of Oscillators*, Pergamon 1966,
//! chapter V.
//!
//! A motion released at rest at `x`, right of the equilibrium, comes to its next turning point on
//! that side at `P(x)`.
//!
//! ```text
//! P(x) = x             a cycle;    P(x) - x falls there: it attracts, and rises: it repels
//! t -> -t, x' -> -x'   turns what repels into what attracts
//! ```
//!
//! A cycle that attracts is found forward in time, one that repels backward, so that errors shrink
//! along the way however strongly it does either. Relaxation oscillations, slow but for their
//! jumps, are stiff: an implicit method follows them where Runge-Kutta would need too many steps.
//! Lengths are measured in an amplitude and times in the linear frequency: units do not matter.

use crate::numeric::ode::root::find_root;
use crate::numeric::ode::{Event, IntegrationOptions, State, StopReason, Trajectory, integrate};

/// Tolerance per step.
const STEP_TOLERANCE: f64 = 1e-13;

/// Relative error of a return to the start that counts as rounding.
const ROUNDING: f64 = 1e-11;

/// Tolerance per step of the implicit method, and the relative error of a return that then counts
/// as rounding.
const STIFF_TOLERANCE: f64 = 1e-14;
const STIFF_ROUNDING: f64 = 1e-8;

/// Largest number of steps of one return: in the search by rings, of a relaxation oscillation, and
/// by the implicit method.
const STEPS_OF_SEARCH: usize = 20_000;
const STEPS_OF_RELAXATION: usize = 40_000;
const STIFF_STEPS: usize = 40_000;

/// The longest time of a return, in radians of the linear frequency, by the explicit and by the
/// implicit method.
const LONGEST: f64 = 1e4;
const STIFF_LONGEST: f64 = 1e12;

/// Starts of the search: `RATIO^k` amplitudes for `|k| <= RINGS`, from a sixtieth of an amplitude
/// to sixty.
const RATIO: f64 = 1.15;
const RINGS: i32 = 30;

/// Distance, in amplitudes, beyond which a motion that has not turned is lost: no cycle that is
/// looked for reaches as far.
const GONE: f64 = 1e4;

/// Number of consecutive rings without a return after which the search on that side ends.
const LOST_RINGS: usize = 4;

/// The equation `x'' = acceleration(x, x')`, with its scales of length and time.
pub struct AutonomousEquation<'a> {
    /// The acceleration.
    pub acceleration: &'a dyn Fn(f64, f64) -> f64,
    /// The equilibrium about which the motion oscillates.
    pub equilibrium: f64,
    /// Approximate amplitude of the cycle, positive: the one nearest to it, by ratio, is found.
    pub amplitude: f64,
    /// Approximate linear frequency, positive.
    pub frequency: f64,
}

/// The reason why no cycle was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoLimitCycle {
    /// There seems to be no limit cycle.
    #[error(
        "no limit cycle with a turning point between x = {from:.3e} and x = {to:.3e}, forward or backward in time"
    )]
    NoneBetween {
        /// Lower end of the search.
        from: f64,
        /// Upper end of the search.
        to: f64,
    },
    /// The motion runs away instead.
    #[error(
        "no limit cycle: released at rest from x = {from:.3e} the motion escapes to infinity, and none comes back nearby"
    )]
    Escapes {
        /// The release point.
        from: f64,
    },
    /// A relaxation oscillation with parts of too different speed.
    #[error(
        "the true motion is too stiff to be followed in double precision, even by an implicit method"
    )]
    TooStiff,
}

/// A true limit cycle, from its turning point right of the equilibrium.
pub struct NumericalLimitCycle {
    path: Trajectory,
    attracts: bool,
    equilibrium: f64,
    amplitude: f64,
    frequency: f64,
}

impl NumericalLimitCycle {
    /// The period.
    pub fn period(&self) -> f64 {
        self.path.end().t / self.frequency
    }

    /// Whether motions near it come closer as time goes on.
    pub fn attracts(&self) -> bool {
        self.attracts
    }

    /// Displacement and velocity; `t = 0` is the turning point, and times repeat with the period.
    pub fn phase_point_at(&self, t: f64) -> (f64, f64) {
        let place = (t / self.period()).rem_euclid(1.0) * self.path.end().t;
        let (place, sign) = match self.attracts {
            true => (place, 1.0),
            false => (self.path.end().t - place, -1.0),
        };
        let (x, v) = self.path.phase_point_at(place).unwrap_or((f64::NAN, f64::NAN));
        let x = self.equilibrium + self.amplitude * x;
        (x, sign * self.amplitude * self.frequency * v)
    }
}

/// Returns the limit cycle nearest to the amplitude of `equation`. If `attracts` is given, a cycle
/// that attracts (`true`) or repels (`false`) is preferred.
///
/// # Errors
/// [`NoLimitCycle`] if no cycle is found within a factor of sixty of the amplitude.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::return_map::{AutonomousEquation, nearest_limit_cycle};
///
/// // Van der Pol with mu = 1: the period of the cycle is 6.6632868593.
/// let equation = AutonomousEquation {
///     acceleration: &|x, v| (1.0 - x * x) * v - x,
///     equilibrium: 0.0,
///     amplitude: 2.0,
///     frequency: 1.0,
/// };
/// let cycle = nearest_limit_cycle(&equation, Some(true)).map_err(|_| "no cycle")?;
/// assert!((cycle.period() - 6.663_286_859_3).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn nearest_limit_cycle(
    equation: &AutonomousEquation,
    attracts: Option<bool>,
) -> Result<NumericalLimitCycle, NoLimitCycle> {
    let directions: &[&[bool]] = match attracts {
        Some(true) => &[&[true], &[false]],
        Some(false) => &[&[false], &[true]],
        None => &[&[true, false]],
    };
    let (mut too_stiff, mut escapes) = (false, false);
    for directions in directions {
        let mut searched = Vec::new();
        for &attracts in *directions {
            match at_once(equation, attracts) {
                Ok(Some(cycle)) => return Ok(cycle),
                Ok(None) | Err(NoReturn::Away) => searched.push(attracts),
                Err(NoReturn::Escapes) => {
                    escapes |= attracts;
                    searched.push(attracts);
                }
                Err(NoReturn::TooManySteps) => too_stiff = true,
            }
        }
        if searched.is_empty() {
            break;
        }
        if let Some(cycle) = by_rings(equation, &searched) {
            return Ok(cycle);
        }
    }
    if too_stiff {
        return Err(NoLimitCycle::TooStiff);
    }
    if escapes {
        return Err(NoLimitCycle::Escapes { from: equation.equilibrium + equation.amplitude });
    }
    Err(NoLimitCycle::NoneBetween {
        from: equation.equilibrium + equation.amplitude * RATIO.powi(-RINGS),
        to: equation.equilibrium + equation.amplitude * RATIO.powi(RINGS),
    })
}

/// Finds a cycle of strong attraction, such as a relaxation oscillation, directly: after two
/// returns the motion is on it to the last digit. Returns `None` if the returns do not converge so
/// fast.
fn at_once(
    equation: &AutonomousEquation,
    attracts: bool,
) -> Result<Option<NumericalLimitCycle>, NoReturn> {
    let explicit = cycle_by_returns(ROUNDING, equation, attracts, &|start| {
        swing(equation, attracts, start, STEPS_OF_RELAXATION)
    });
    match explicit {
        Err(NoReturn::TooManySteps) => {
            cycle_by_returns(STIFF_ROUNDING, equation, attracts, &|start| {
                stiff_swing(equation, attracts, start)
            })
        }
        explicit => explicit,
    }
}

/// Returns the cycle onto which a few returns lead, to the relative accuracy `rounding`; `None` if
/// there is none.
fn cycle_by_returns(
    rounding: f64,
    equation: &AutonomousEquation,
    attracts: bool,
    swing: &dyn Fn(f64) -> Result<Trajectory, NoReturn>,
) -> Result<Option<NumericalLimitCycle>, NoReturn> {
    const RETURNS: usize = 3;
    let mut start = 1.0;
    for _ in 0..RETURNS {
        let path = swing(start)?;
        let (before, after) = (start, path.end().x);
        if (after - before).abs() <= rounding * after {
            return Ok(Some(cycle(equation, attracts, path)));
        }
        start = after;
    }
    Ok(None)
}

/// Finds a cycle in the ring nearest to the amplitude in which P(x) - x changes from positive to
/// negative.
fn by_rings(equation: &AutonomousEquation, directions: &[bool]) -> Option<NumericalLimitCycle> {
    let growth = |attracts: bool, start: f64| {
        let path = swing(equation, attracts, start, STEPS_OF_SEARCH);
        path.map_or(f64::NAN, |path| path.end().x - start)
    };
    // P(x) - x at the inner and at the outer end of the range searched so far, for each direction
    // of time.
    let mut ends: Vec<[f64; 2]> =
        directions.iter().map(|&attracts| [growth(attracts, 1.0); 2]).collect();
    let mut lost = vec![[0; 2]; directions.len()];
    for ring in 1..=RINGS {
        for ((&attracts, ends), lost) in directions.iter().zip(&mut ends).zip(&mut lost) {
            for (side, sign) in [(0, -1), (1, 1)] {
                // If motions from several neighbouring rings do not return, those from beyond do
                // not either.
                if lost[side] == LOST_RINGS {
                    continue;
                }
                let [known, place] = [ring - 1, ring].map(|ring| RATIO.powi(sign * ring));
                let (before, after) = (ends[side], growth(attracts, place));
                ends[side] = after;
                lost[side] = if after.is_nan() { lost[side] + 1 } else { 0 };
                let (inner, outer) = if side == 0 { (after, before) } else { (before, after) };
                if !(inner > 0.0 && outer <= 0.0) {
                    continue;
                }
                let Ok(fixed) = find_root(|start| growth(attracts, start), known, place) else {
                    continue;
                };
                if let Ok(path) = swing(equation, attracts, fixed, STEPS_OF_SEARCH) {
                    return Some(cycle(equation, attracts, path));
                }
            }
        }
    }
    None
}

fn cycle(equation: &AutonomousEquation, attracts: bool, path: Trajectory) -> NumericalLimitCycle {
    NumericalLimitCycle {
        path,
        attracts,
        equilibrium: equation.equilibrium,
        amplitude: equation.amplitude,
        frequency: equation.frequency,
    }
}

/// The reason why a motion did not return.
enum NoReturn {
    Away,
    Escapes,
    TooManySteps,
}

/// The motion from rest at `start` amplitudes to the next turning point on the same side, forward
/// in time or backward.
fn swing(
    equation: &AutonomousEquation,
    forward: bool,
    start: f64,
    maximum_steps: usize,
) -> Result<Trajectory, NoReturn> {
    let options =
        IntegrationOptions { maximum_steps, ..IntegrationOptions::with_tolerance(STEP_TOLERANCE) };
    follow(equation, forward, start, LONGEST, &options)
}

/// The motion of [`swing`] by an implicit method, which takes long steps between the jumps.
fn stiff_swing(
    equation: &AutonomousEquation,
    forward: bool,
    start: f64,
) -> Result<Trajectory, NoReturn> {
    let options = IntegrationOptions {
        maximum_steps: STIFF_STEPS,
        // Between its jumps a relaxation oscillation moves at a small fraction of its largest
        // speed.
        absolute_tolerance: 1e-4 * STIFF_TOLERANCE,
        stiff: true,
        ..IntegrationOptions::with_tolerance(STIFF_TOLERANCE)
    };
    follow(equation, forward, start, STIFF_LONGEST, &options)
}

fn follow(
    equation: &AutonomousEquation,
    forward: bool,
    start: f64,
    longest: f64,
    options: &IntegrationOptions,
) -> Result<Trajectory, NoReturn> {
    let AutonomousEquation { acceleration, equilibrium, amplitude, frequency } = equation;
    let speed = amplitude * frequency * if forward { 1.0 } else { -1.0 };
    let unit = amplitude * frequency * frequency;
    let scaled =
        |_: f64, x: f64, v: f64| acceleration(equilibrium + amplitude * x, speed * v) / unit;
    let state = State { t: 0.0, x: start, v: 0.0 };
    let turning = Event::stop(|_, _, v| v).falling();
    let path =
        integrate(scaled, state, longest, &[turning], options).map_err(|_| NoReturn::Away)?;
    match path.stop_reason() {
        // A cycle goes around the equilibrium: a motion that turns back on one side of it is
        // rounding, as for van der Pol's equation at mu = 1e30.
        StopReason::Event { .. } if path.end().x > 0.0 && path.knots().any(|knot| knot.x < 0.0) => {
            Ok(path)
        }
        StopReason::Event { .. } if options.stiff => Err(NoReturn::TooManySteps),
        // Damping that grows with the distance makes the steps of a motion that runs away ever
        // shorter.
        StopReason::MaximumSteps { .. }
        | StopReason::StepTooSmall { .. }
        | StopReason::NonFinite { .. }
            if path.end().x.abs() > GONE =>
        {
            Err(NoReturn::Escapes)
        }
        StopReason::MaximumSteps { .. } => Err(NoReturn::TooManySteps),
        _ => Err(NoReturn::Away),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cycle of x'' = acceleration about zero, found from a guess.
    fn found(acceleration: &dyn Fn(f64, f64) -> f64, guess: f64) -> NumericalLimitCycle {
        let equation =
            AutonomousEquation { acceleration, equilibrium: 0.0, amplitude: guess, frequency: 1.0 };
        nearest_limit_cycle(&equation, None).expect("a limit cycle")
    }

    fn van_der_pol(mu: f64) -> NumericalLimitCycle {
        found(&move |x, v| mu * (1.0 - x * x) * v - x, 2.0)
    }

    /// The period of van der Pol's equation by its Taylor series, which shares nothing with
    /// Runge-Kutta: from passage to passage through x = 0. With u = 1 - x^2 and v = x', Cauchy
    /// products give `v_n` and `x_n`.
    fn period_by_taylor(mu: f64, tolerance: f64) -> f64 {
        const ORDER: usize = 30;
        let series = |x0: f64, v0: f64| {
            let (mut x, mut v, mut u) = (vec![x0], vec![v0], vec![]);
            for n in 0..ORDER {
                let square: f64 = (0..=n).map(|i| x[i] * x[n - i]).sum();
                u.push(if n == 0 { 1.0 - square } else { -square });
                let product: f64 = (0..=n).map(|i| u[i] * v[n - i]).sum();
                let next = n as f64 + 1.0;
                x.push(v[n] / next);
                v.push((mu * product - x[n]) / next);
            }
            (x, v)
        };
        let at = |series: &[f64], h: f64| series.iter().rev().fold(0.0, |sum, term| sum * h + term);
        let (mut t, mut state) = (0.0, (2.0, 0.0));
        let mut passages: Vec<f64> = vec![];
        while passages.len() < 12 {
            let (x, v) = series(state.0, state.1);
            let step = |coefficients: &[f64], k: usize| {
                (tolerance / coefficients[k].abs()).powf(1.0 / k as f64)
            };
            let h = [ORDER - 1, ORDER].into_iter().flat_map(|k| [step(&x, k), step(&v, k)]);
            let h = 0.5 * h.fold(1.0, f64::min);
            let next = (at(&x, h), at(&v, h));
            if state.0 < 0.0 && next.0 >= 0.0 {
                passages.push(t + find_root(|h| at(&x, h), 0.0, h).unwrap());
            }
            (t, state) = (t + h, next);
        }
        passages[11] - passages[10]
    }

    #[test]
    fn van_der_pol_has_the_period_of_its_taylor_series() {
        for mu in [0.5, 1.0, 3.0, 10.0, 20.0] {
            let [coarse, fine] = [1e-12, 1e-16].map(|tolerance| period_by_taylor(mu, tolerance));
            let period = van_der_pol(mu).period();
            assert!((coarse / fine - 1.0).abs() < 1e-10, "mu = {mu}: {coarse} {fine}");
            assert!((period / fine - 1.0).abs() < 1e-10, "mu = {mu}: {period} {fine}");
        }
    }

    #[test]
    fn relaxation_oscillations_follow_their_asymptotics() {
        // T = (3 - 2 log 2) mu + 3 alpha mu^(-1/3) + ..., alpha = 2.338107 the first zero of
        // Ai(-x): J. Grasman, *Asymptotic Methods for Relaxation Oscillations and Applications*,
        // Springer 1987. The next term is negative.
        let slow = 3.0 - 2.0 * 2.0_f64.ln();
        let rest = |mu: f64| (van_der_pol(mu).period() - slow * mu) * mu.cbrt() / (3.0 * 2.338_107);
        let [at_10, at_50, at_200] = [10.0, 50.0, 200.0].map(rest);
        assert!(
            0.8 < at_10 && at_10 < at_50 && at_50 < at_200 && at_200 < 1.0,
            "{at_10} {at_50} {at_200}"
        );
    }

    #[test]
    fn stiff_cycles_have_the_period_of_dorodnitsyn() {
        // ... - (2/3) log(mu)/mu - 1.3246/mu + O(mu^(-4/3)): A. A. Dorodnitsyn, Prikl. Mat. Mekh.
        // 11 (1947) 313-328, with the last coefficient of M. Urabe, IEEE Trans. Circuit Theory CT-7
        // (1960) 382-386.
        let asymptotic = |mu: f64| {
            (3.0 - 2.0 * 2.0_f64.ln()) * mu + 3.0 * 2.338_107_410_459_767 / mu.cbrt()
                - 2.0 / 3.0 * mu.ln() / mu
                - 1.3246 / mu
        };
        for mu in [1e3, 1e4, 1e5, 1e6, -1e3] {
            let cycle = van_der_pol(mu);
            let (period, expected) = (cycle.period(), asymptotic(mu.abs()));
            let next = mu.abs().powf(-4.0 / 3.0);
            assert!(
                (period - expected).abs() < next + 1e-8 * period,
                "mu = {mu}: {period} {expected}"
            );
            assert_eq!(cycle.attracts(), mu > 0.0);
            // Turning points: 2 + alpha mu^(-4/3)/3 + ...
            let turning = 2.0 + 2.338_107 * next / 3.0;
            assert!(
                (cycle.phase_point_at(0.0).0 - turning).abs() < next,
                "{}",
                cycle.phase_point_at(0.0).0
            );
            // Half a period later the mirror image.
            for k in 0..50 {
                let t = period * f64::from(k) / 50.0;
                let (there, opposite) =
                    (cycle.phase_point_at(t).0, cycle.phase_point_at(t + 0.5 * period).0);
                assert!((there + opposite).abs() < 1e-5, "{mu} {t}: {there} {opposite}");
            }
        }
    }

    #[test]
    fn beyond_double_precision_there_is_no_period() {
        for mu in [1e12, 1e20, 1e30, 1e100] {
            let acceleration = move |x: f64, v: f64| mu * (1.0 - x * x) * v - x;
            let equation = AutonomousEquation {
                acceleration: &acceleration,
                equilibrium: 0.0,
                amplitude: 2.0,
                frequency: 1.0,
            };
            if let Ok(cycle) = nearest_limit_cycle(&equation, None) {
                let slow = (3.0 - 2.0 * 2.0_f64.ln()) * mu;
                assert!(
                    (cycle.period() / slow - 1.0).abs() < 1e-3,
                    "mu = {mu}: {}",
                    cycle.period()
                );
            }
        }
    }

    #[test]
    fn the_implicit_method_agrees_with_the_explicit_one() {
        for mu in [5.0, 30.0] {
            let acceleration = |x: f64, v: f64| mu * (1.0 - x * x) * v - x;
            let equation = AutonomousEquation {
                acceleration: &acceleration,
                equilibrium: 0.0,
                amplitude: 2.0,
                frequency: 1.0,
            };
            let path = stiff_swing(&equation, true, 1.0)
                .and_then(|path| stiff_swing(&equation, true, path.end().x));
            let Ok(path) = path else { panic!("no return") };
            let (implicit, explicit) = (cycle(&equation, true, path), van_der_pol(mu));
            assert!((implicit.period() / explicit.period() - 1.0).abs() < 1e-8);
            for k in 0..200 {
                let t = 0.005 * f64::from(k) * explicit.period();
                let ((x, v), (y, w)) = (implicit.phase_point_at(t), explicit.phase_point_at(t));
                assert!(
                    (x - y).abs() < 1e-6 && (v - w).abs() < 1e-4 * mu,
                    "{mu} {t}: {x} {y} {v} {w}"
                );
            }
        }
    }

    #[test]
    fn the_energy_of_a_cycle_balances() {
        // Over one period the damping does no work: int (1 - x^2) x'^2 dt = 0.
        for mu in [0.1, -0.3, 2.0, -5.0, 10.0] {
            let cycle = van_der_pol(mu);
            let place = |k: i32| cycle.period() * f64::from(k) / 20_000.0;
            let work = |weight: &dyn Fn(f64) -> f64| {
                let powers = (0..20_000).map(|k| cycle.phase_point_at(place(k)));
                powers.map(|(x, v)| weight(x) * v * v).sum::<f64>()
            };
            let (net, whole) = (work(&|x| 1.0 - x * x), work(&|x| (1.0 - x * x).abs()));
            assert!(net.abs() < 1e-8 * whole, "mu = {mu}: {net} of {whole}");
            assert_eq!(cycle.attracts(), mu > 0.0);
        }
    }

    #[test]
    fn with_mu_negative_the_same_cycle_runs_backward() {
        for mu in [0.3, 3.0, 20.0] {
            let (forward, backward) = (van_der_pol(mu), van_der_pol(-mu));
            assert!((forward.period() / backward.period() - 1.0).abs() < 1e-10);
            for k in 0..20 {
                let t = 0.05 * f64::from(k) * forward.period();
                let ((x, v), (y, w)) = (forward.phase_point_at(t), backward.phase_point_at(-t));
                assert!(
                    (x - y).abs() < 1e-7 && (v + w).abs() < 1e-6 * mu,
                    "mu = {mu}, t = {t}: {x} {y} {v} {w}"
                );
            }
        }
    }

    #[test]
    fn units_do_not_matter() {
        let plain = van_der_pol(2.0);
        for (length, rate) in [(1e-9, 1e6), (1e12, 1e-8), (1e-20, 1e20)] {
            let acceleration = |x: f64, v: f64| {
                let (x, v) = (x / length, v / (length * rate));
                length * rate * rate * (2.0 * (1.0 - x * x) * v - x)
            };
            let equation = AutonomousEquation {
                acceleration: &acceleration,
                equilibrium: 0.0,
                amplitude: 3.0 * length,
                frequency: rate,
            };
            let cycle = nearest_limit_cycle(&equation, None).expect("a limit cycle");
            assert!((cycle.period() * rate / plain.period() - 1.0).abs() < 1e-10);
            assert!(
                (cycle.phase_point_at(0.0).0 / length / plain.phase_point_at(0.0).0 - 1.0).abs()
                    < 1e-10
            );
        }
    }

    #[test]
    fn of_two_cycles_the_nearest() {
        // x' (1 - 3 x^2 + x^4): to first order 1 - 3 a^2/4 + a^4/8 = 0, a^2 = 2 and 4; the outer
        // one attracts for eps > 0.
        let [inner, outer] = [2.0_f64.sqrt(), 2.0];
        for eps in [0.001, -0.001] {
            let acceleration = move |x: f64, v: f64| -eps * (1.0 - 3.0 * x * x + x.powi(4)) * v - x;
            for (guess, amplitude) in [(0.5, inner), (1.5, inner), (1.9, outer), (4.0, outer)] {
                let cycle = found(&acceleration, guess);
                assert!(
                    (cycle.phase_point_at(0.0).0 / amplitude - 1.0).abs() < 1e-4,
                    "{guess}: {}",
                    cycle.phase_point_at(0.0).0
                );
                assert_eq!(cycle.attracts(), (amplitude == outer) == (eps > 0.0));
            }
        }
    }

    #[test]
    fn where_there_is_none_the_search_ends() {
        let damped = |x: f64, v: f64| -0.1 * v - x;
        let search = |acceleration: &dyn Fn(f64, f64) -> f64| {
            let equation = AutonomousEquation {
                acceleration,
                equilibrium: 0.0,
                amplitude: 2.0,
                frequency: 1.0,
            };
            nearest_limit_cycle(&equation, None).err()
        };
        assert!(matches!(search(&damped), Some(NoLimitCycle::NoneBetween { .. })));
        // Beyond its separatrix at 0.45 a soft spring throws the motion out, damped or not: x' = 50
        // x far away.
        for (mu, cubic) in [(0.1, -5.0), (0.1, -0.3), (1.0, -20.0), (1e-3, -1.0)] {
            let soft = move |x: f64, v: f64| mu * (1.0 - x * x) * v - x - cubic * x.powi(3);
            let found = search(&soft);
            assert!(
                matches!(found, Some(NoLimitCycle::Escapes { from: 2.0 })),
                "{mu}, {cubic}: {found:?}"
            );
        }
    }
}

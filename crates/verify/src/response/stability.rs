//! The true motion near a solution of the balance, and its stability by Floquet's multipliers.
//!
//! ```text
//! M' = [0 1; -f_x -f_v] M,  M(0) = 1:   the multipliers are the eigenvalues of M(T),   det M(T) = exp(-integral of f_v over T)
//! ```
//!
//! In: a start near a motion of period T. Out: the motion itself, found by shooting (Newton's
//! method for the start that comes back after a period), its first harmonic and its peaks, and its
//! multipliers; it is stable if both lie inside the unit circle (A. H. Nayfeh and B. Balachandran,
//! *Applied Nonlinear Dynamics*, Wiley 1995, chapters 3 and 6). Everything is integrated on the
//! equation as it was given, by Taylor series, or by Runge-Kutta where it has none; only the start is
//! taken from the balance.

use nalgebra::{DMatrix, Matrix2};
use num_complex::Complex;

use super::driven::Driven;
use super::jump::{StopCondition, VariationalMotion, evaluations_of, follow, positions_on};
use crate::interrupt::Interrupt;
use crate::numeric::ode::{IntegrationOptions, Point, Trajectory, integrate_first_order};
use crate::numeric::periodic::{PeriodicOrbit, Shooting, eigenvalues_of_two};
use crate::system::Path;

/// Number of samples of a period for its harmonics and peaks.
pub(super) const SAMPLES: usize = 256;

/// The monodromy matrix: the image of a small disturbance of a periodic motion after one period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floquet {
    /// M(T).
    pub monodromy: Matrix2<f64>,
    /// Whether nothing drives the motion: M(T) is then diagonal, and its second multiplier, along
    /// the motion, is 1.
    pub self_excited: bool,
}

impl Floquet {
    /// The eigenvalues of M(T), the larger first; for a self-excited motion the nontrivial one,
    /// then the one that is 1.
    pub fn multipliers(&self) -> [Complex<f64>; 2] {
        match self.self_excited {
            true => [self.monodromy[(0, 0)], 1.0].map(Complex::from),
            false => eigenvalues_of_two(self.monodromy.trace(), self.monodromy.determinant()),
        }
    }

    /// The absolute value of the multiplier that decides about stability, the larger one.
    pub fn largest(&self) -> f64 {
        self.multipliers()[0].norm()
    }
}

/// A periodic motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueMotion {
    /// Position and velocity at phase zero.
    pub start: [f64; 2],
    /// Its frequency.
    pub frequency: f64,
    /// The multipliers.
    pub floquet: Floquet,
    /// Coefficients of cos(theta) and sin(theta).
    pub first_harmonic: [f64; 2],
    /// Half of the way from the lowest to the highest point.
    pub peak: f64,
    /// The fraction of the period during which the motion sticks.
    pub stuck: f64,
}

impl TrueMotion {
    /// A motion from its positions over a period at equal steps.
    pub(super) fn new(
        start: [f64; 2],
        frequency: f64,
        floquet: Floquet,
        positions: &[f64],
        stuck: f64,
    ) -> Self {
        let first_harmonic = first_harmonic(positions);
        Self {
            start,
            frequency,
            floquet,
            first_harmonic,
            peak: half_of_peak_to_peak(positions),
            stuck,
        }
    }
}

/// Relative tolerance of a step in verification.
pub(super) const TOLERANCE: f64 = 1e-10;

/// Largest number of steps of a period.
const STEPS: usize = 4_000;

pub(super) fn options(size: f64, tolerance: f64) -> IntegrationOptions {
    IntegrationOptions {
        absolute_tolerance: tolerance * size.clamp(1e-12, 1.0),
        maximum_steps: STEPS,
        ..IntegrationOptions::with_tolerance(tolerance)
    }
}

/// Largest change of the start by shooting, relative to the size of the motion, and of the period.
pub(super) const FAR: f64 = 0.3;

/// A test whether shooting has converged, from the closure error of an orbit and the size of the
/// next Newton step.
pub(super) fn convergence_test(closely: f64) -> impl FnMut(f64, f64) -> bool {
    let mut before = f64::INFINITY;
    move |missed, moved| {
        // Near a fold rounding is magnified: steps that no longer shrink have converged.
        let stalled = moved <= 1e-6 && moved >= 0.5 * before;
        before = moved;
        stalled || moved <= closely || missed <= 1e-12
    }
}

/// The periodic motion whose start is near this one; `None` if shooting does not converge, or moves
/// far away.
pub fn periodic_motion(
    driven: &Driven,
    guess: [f64; 2],
    parameter: f64,
    size: f64,
) -> Option<TrueMotion> {
    let omega = driven.frequency_at(parameter);
    let (period, sizes) = (std::f64::consts::TAU / omega, [size, size * omega]);
    let follow = |start: [f64; 2], period: f64| {
        let options = options(start[0].abs().max(start[1].abs() / omega), TOLERANCE);
        let course = follow(driven, start, parameter, StopCondition::Time(period), &options)?;
        let [x, v, variations @ ..] = course.end;
        Some(([x, v], Matrix2::from_column_slice(&variations), course))
    };
    let solve = |matrix: DMatrix<f64>, missed| matrix.lu().solve(&missed);
    let shooting =
        Shooting { guess, period, rates: None, sizes, solve, most: 12, far: FAR, known: &[] };
    let PeriodicOrbit { start, monodromy, path, .. } =
        shooting.orbit(follow, convergence_test(1e-9))?;
    let floquet = Floquet { monodromy, self_excited: false };
    Some(TrueMotion::new(start, omega, floquet, &path.positions(SAMPLES), path.stuck()))
}

/// The multipliers of a motion that is given with its frequency, not followed: `motion` has
/// position and velocity at a phase.
pub fn multipliers_along(
    driven: &Driven,
    parameter: f64,
    omega: f64,
    motion: impl Fn(f64) -> [f64; 2],
) -> Option<Floquet> {
    let rates = |t: f64, y: &[f64; 4], rates: &mut [f64; 4]| {
        let [position, velocity] = motion(omega * t);
        let [by_position, by_velocity, _] =
            driven.slopes(&[position, velocity, omega * t, parameter]);
        *rates = [
            y[1],
            -by_position * y[0] - by_velocity * y[1],
            y[3],
            -by_position * y[2] - by_velocity * y[3],
        ];
    };
    let begin = Point { t: 0.0, y: [1.0, 0.0, 0.0, 1.0] };
    let path = integrate_first_order(
        rates,
        begin,
        std::f64::consts::TAU / omega,
        &[],
        &options(1.0, TOLERANCE),
    )
    .ok()?;
    let end = path.end().y;
    path.is_complete().then_some(Floquet {
        monodromy: Matrix2::new(end[0], end[2], end[1], end[3]),
        self_excited: false,
    })
}

/// Coefficients of cos(theta) and sin(theta) of a period in equal steps.
pub fn first_harmonic(positions: &[f64]) -> [f64; 2] {
    let count = positions.len() as f64;
    let mut sums = [0.0; 2];
    for (index, position) in positions.iter().enumerate() {
        let (sine, cosine) = (std::f64::consts::TAU * index as f64 / count).sin_cos();
        sums[0] += position * cosine;
        sums[1] += position * sine;
    }
    sums.map(|sum| 2.0 * sum / count)
}

/// Half of the way from the lowest to the highest point of a period in equal steps, by the parabola
/// through three of them.
pub fn half_of_peak_to_peak(positions: &[f64]) -> f64 {
    let count = positions.len();
    let top = |sign: f64| {
        let highest = (0..count)
            .max_by(|one, other| (sign * positions[*one]).total_cmp(&(sign * positions[*other])));
        let Some(middle) = highest else {
            return 0.0;
        };
        let value = |offset: usize| sign * positions[(middle + offset) % count];
        let [before, here, after] = [value(count - 1), value(0), value(1)];
        let curvature = before - 2.0 * here + after;
        match curvature < 0.0 {
            true => here - (after - before).powi(2) / (8.0 * curvature),
            false => here,
        }
    };
    0.5 * (top(1.0) + top(-1.0))
}

/// The budget of several simulations together: the evaluations of the force that are left, and the
/// interrupt.
#[derive(Clone, Copy, Debug)]
pub struct SimulationBudget {
    /// Number of evaluations left.
    pub evaluations: usize,
    /// The interrupt, tested after every period.
    pub interrupt: Interrupt,
}

impl SimulationBudget {
    /// Subtracts the cost of a period. Returns whether another one may be computed.
    pub(super) fn spend(&mut self, evaluations: usize) -> bool {
        self.evaluations = self.evaluations.saturating_sub(evaluations);
        self.evaluations > 0 && !self.interrupt.is_requested()
    }
}

/// The steady state that a simulation has reached.
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    /// Position and velocity at phase zero.
    pub state: [f64; 2],
    /// The number of periods after which it repeats itself, or will once a decaying transient is
    /// gone; `None` if it does not within eight.
    pub returns_after: Option<usize>,
    /// Its positions over the last period, at equal steps.
    pub positions: Vec<f64>,
}

/// A period of a simulation, in one piece or in legs between the jumps of the force.
enum Period {
    Series(Path),
    One(Trajectory<Point<[f64; 2]>>),
    Legs(VariationalMotion),
}

impl Period {
    /// Position and velocity at the end; `None` if it was not reached.
    fn end(&self) -> Option<[f64; 2]> {
        match self {
            Self::Series(path) => path.states_at(path.end())?.try_into().ok(),
            Self::One(path) => path.is_complete().then(|| path.end().y),
            Self::Legs(course) => Some([course.end[0], course.end[1]]),
        }
    }

    fn positions(&self, count: usize) -> Vec<f64> {
        match self {
            Self::Series(path) => positions_on(path, count),
            Self::One(path) => {
                path.samples(count + 1).take(count).map(|point| point.y[0]).collect()
            }
            Self::Legs(course) => course.positions(count),
        }
    }

    fn evaluations(&self) -> usize {
        match self {
            Self::Series(path) => evaluations_of(path),
            Self::One(path) => path.evaluations(),
            Self::Legs(course) => course.evaluations(),
        }
    }
}

/// Follows the equation as it was given from a start, period by period, until it repeats itself to
/// `closely` (of its size), or `most` periods are over; the tolerance of a step is a thousandth of
/// that. `None` if it cannot be followed: it escapes, or the `budget` is spent.
pub fn settle(
    driven: &Driven,
    start: [f64; 2],
    parameter: f64,
    (most, closely): (usize, f64),
    budget: &mut SimulationBudget,
) -> Option<Settled> {
    /// Largest number of periods within which a motion may repeat itself.
    const LONGEST: usize = 8;
    const BOUND: f64 = 1e8;
    /// Number of periods over which the largest difference is taken, and the largest fraction of it
    /// that may remain a quarter of the run later.
    const WINDOW: usize = 16;
    const FALLING: f64 = 0.9;
    let omega = driven.frequency_at(parameter);
    let period = std::f64::consts::TAU / omega;
    let rates = |t: f64, y: &[f64; 2], rates: &mut [f64; 2]| {
        *rates = [y[1], -driven.force_in_time(&[y[0], y[1], t, parameter])];
    };
    let settings = |size: f64| options(size, (1e-3 * closely).clamp(1e-13, 1e-6));
    let mut states = vec![start];
    let mut quiet = 0;
    let mut last = None;
    for _ in 0..most {
        let begin = states.last().copied()?;
        let size = begin[0].abs().max(begin[1].abs() / omega);
        let path = if driven.jumps() > 0 {
            let until = StopCondition::Time(period);
            Period::Legs(follow(driven, begin, parameter, until, &settings(size))?)
        } else if let Some(path) = driven.by_series(begin, parameter, period) {
            Period::Series(path)
        } else {
            let begin = Point { t: 0.0, y: begin };
            Period::One(integrate_first_order(rates, begin, period, &[], &settings(size)).ok()?)
        };
        let end = path.end()?;
        if !budget.spend(path.evaluations()) || size > BOUND {
            return None;
        }
        let moved = (end[0] - begin[0]).hypot((end[1] - begin[1]) / omega);
        let away = path.positions(32).into_iter().chain([end[0]]);
        let extent = away.fold(0.0_f64, |most, position| most.max((position - begin[0]).abs()));
        states.push(end);
        last = Some(path);
        // A state of rest counts as periodic.
        quiet = if moved <= closely * extent.max(1e-12) { quiet + 1 } else { 0 };
        if quiet >= 3 {
            break;
        }
    }
    let positions = last?.positions(SAMPLES);
    let state = states.last().copied()?;
    let extent = half_of_peak_to_peak(&positions).max(1e-12);
    let apart = |index: usize, count: usize| {
        let [one, other] = [states.get(index)?, states.get(index.checked_sub(count)?)?];
        Some((one[0] - other[0]).hypot((one[1] - other[1]) / omega))
    };
    let end = states.len() - 1;
    let repeats = |count: usize| apart(end, count).is_some_and(|apart| apart <= 1e-3 * extent);
    // A slowly decaying disturbance repeats itself, too, if its frequency is a fraction of that of
    // the drive.
    let dies_out = |count: usize| {
        let around = |quarter: usize| {
            let last = end * quarter / 4;
            let differences =
                (last.saturating_sub(WINDOW)..=last).filter_map(|index| apart(index, count));
            differences.fold(0.0_f64, f64::max)
        };
        let sizes = [1, 2, 3, 4].map(around);
        end > 8 * WINDOW && sizes.windows(2).all(|pair| pair[1] < FALLING * pair[0])
    };
    Some(Settled {
        state,
        returns_after: (1..=LONGEST).find(|count| repeats(*count) || dies_out(*count)),
        positions,
    })
}

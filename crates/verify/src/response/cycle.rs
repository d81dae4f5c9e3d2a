//! The true limit cycle near a solution of the balance, and its stability.
//!
//! ```text
//! y = (x, x'),   y(T; y_0) = y_0,   flow(y_0) . dy_0 = 0:      [M - 1  flow(y_T)] [dy_0]     [y_T - y_0]
//!                                                             [flow(y_0)^T    0] [ dT ] = - [    0    ]
//! multipliers: 1, along the motion, and det M = exp(-integral of f_v over T)
//! ```
//!
//! In: a start near a motion without drive, and about its frequency. Out: the motion itself by
//! shooting for start and period together (R. Seydel, *Practical Bifurcation and Stability
//! Analysis*, Springer 2010, chapter 7). A motion that repels is followed backward in time, in
//! which it attracts, so that errors shrink on the way. The multiplier along the motion is 1 by
//! itself; the other one is that of Liouville's theorem, which does not cancel however small it is.

use nalgebra::{Matrix2, Matrix3};

use super::driven::Driven;
use super::stability::{
    self, FAR, Floquet, SAMPLES, SimulationBudget, TOLERANCE, TrueMotion, options,
};
use crate::numeric::ode::root::find_root;
use crate::numeric::ode::{Point, Trajectory, integrate_first_order};
use crate::numeric::periodic::{PeriodicOrbit, Shooting};

/// A guess of a limit cycle: start, frequency and size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guess {
    /// Position and velocity.
    pub start: [f64; 2],
    /// 2 pi over the period.
    pub frequency: f64,
    /// The size of the motion.
    pub size: f64,
}

/// The motion over a time with its variations and the integral of -f_v; backward in time where
/// `backward` says so. `None` if it cannot be followed.
fn followed(
    driven: &Driven,
    guess: &Guess,
    start: [f64; 2],
    (period, backward): (f64, bool),
    parameter: f64,
) -> Option<Trajectory<Point<[f64; 7]>>> {
    let sign = if backward { -1.0 } else { 1.0 };
    let rates = |_: f64, y: &[f64; 7], rates: &mut [f64; 7]| {
        let at = [y[0], y[1], 0.0, parameter];
        let [by_position, by_velocity, _] = driven.slopes(&at);
        *rates = [
            sign * y[1],
            -sign * driven.force(&at),
            sign * y[3],
            sign * (-by_position * y[2] - by_velocity * y[3]),
            sign * y[5],
            sign * (-by_position * y[4] - by_velocity * y[5]),
            -by_velocity,
        ];
    };
    let begin = Point { t: 0.0, y: [start[0], start[1], 1.0, 0.0, 0.0, 1.0, 0.0] };
    let path =
        integrate_first_order(rates, begin, period, &[], &options(guess.size, TOLERANCE)).ok()?;
    path.is_complete().then_some(path)
}

/// The periodic motion beside this one, and its frequency; `None` if shooting does not converge, or
/// moves far away.
pub fn true_cycle(
    driven: &Driven,
    guess: &Guess,
    parameter: f64,
    backward: bool,
) -> Option<TrueMotion> {
    let &Guess { frequency, size, .. } = guess;
    let sign = if backward { -1.0 } else { 1.0 };
    let flow = |[x, v]: [f64; 2]| [sign * v, -sign * driven.force(&[x, v, 0.0, parameter])];
    let follow = |start: [f64; 2], period: f64| {
        let path = followed(driven, guess, start, (period, backward), parameter)?;
        let [x, v, a, b, c, d, _] = path.end().y;
        Some(([x, v], Matrix2::new(a, c, b, d), path))
    };
    let shooting = Shooting {
        guess: guess.start,
        period: std::f64::consts::TAU / frequency,
        rates: Some(&flow),
        sizes: [size, size * frequency],
        solve: |matrix, missed| {
            let matrix = Matrix3::from_column_slice(matrix.as_slice());
            let step = matrix.svd(true, true).solve(&missed, 1e-9).ok()?;
            Some(step.resize_vertically(3, 0.0))
        },
        most: 15,
        far: FAR,
        known: &[],
    };
    let PeriodicOrbit { start, period, path, .. } =
        shooting.orbit(follow, stability::convergence_test(1e-10))?;
    let positions: Vec<f64> =
        path.samples(SAMPLES + 1).take(SAMPLES).map(|point| point.y[0]).collect();
    let determinant = path.end().y[6].exp();
    let floquet =
        Floquet { monodromy: Matrix2::new(determinant, 0.0, 0.0, 1.0), self_excited: true };
    let frequency = std::f64::consts::TAU / period;
    Some(TrueMotion::new(start, frequency, floquet, &positions, 0.0))
}

/// Simulates the motion from a start for a number of periods of about the guessed frequency.
/// Returns its frequency by its own return and its positions over that period at equal steps;
/// `None` if it does not return, escapes, or the budget is spent.
pub fn settle_cycle(
    driven: &Driven,
    guess: &Guess,
    parameter: f64,
    periods: usize,
    budget: &mut SimulationBudget,
) -> Option<(f64, Vec<f64>)> {
    const CLOSELY: f64 = 1e-11;
    /// One period plus the possible error of its guess.
    const LONGER: f64 = 1.3;
    /// Largest distance from its start at which a settled simulation counts as returned, relative
    /// to its size.
    const BACK: f64 = 1e-3;
    let period = std::f64::consts::TAU / guess.frequency;
    let rates = |t: f64, y: &[f64; 2], rates: &mut [f64; 2]| {
        *rates = [y[1], -driven.force_in_time(&[y[0], y[1], t, parameter])];
    };
    let mut follow = |start: [f64; 2], duration: f64| {
        let begin = Point { t: 0.0, y: start };
        let path =
            integrate_first_order(rates, begin, duration, &[], &options(guess.size, CLOSELY))
                .ok()?;
        let more = budget.spend(path.evaluations());
        (path.is_complete() && more).then_some(path)
    };
    let mut state = guess.start;
    for _ in 0..periods {
        state = follow(state, period)?.end().y;
    }
    let path = follow(state, LONGER * period)?;
    let [x, v] = state;
    let flow = [v, -driven.force(&[x, v, 0.0, parameter])];
    // The return is the crossing of the line through the start at right angles to the trajectory.
    let across = |t: f64| {
        path.state_at(t).map_or(f64::NAN, |point| {
            (point.y[0] - x) * flow[0] + (point.y[1] - v) * flow[1] / guess.frequency.powi(2)
        })
    };
    let away = |t: f64| {
        path.state_at(t).map_or(f64::INFINITY, |point| {
            (point.y[0] - x).hypot((point.y[1] - v) / guess.frequency)
        })
    };
    const CELLS: u32 = 60;
    let time = |cell: u32| {
        period * (2.0 - LONGER + 2.0 * (LONGER - 1.0) * f64::from(cell) / f64::from(CELLS))
    };
    let returns =
        (0..CELLS).filter(|cell| across(time(*cell)) < 0.0 && across(time(cell + 1)) >= 0.0);
    let own = returns
        .filter_map(|cell| find_root(across, time(cell), time(cell + 1)).ok())
        .find(|time| away(*time) <= BACK * guess.size)?;
    let positions =
        (0..SAMPLES).filter_map(|sample| path.state_at(own * sample as f64 / SAMPLES as f64));
    Some((std::f64::consts::TAU / own, positions.map(|point| point.y[0]).collect()))
}

//! The true frequency, by ways that share nothing with the formulas.
//!
//! Conservative motion (L. D. Landau and E. M. Lifshitz, *Mechanics*, 3rd ed., section 11): between the turning points `x_0`
//! and `x_1`, with `U(x) = V(x_0) - V(x)`,
//!
//! ```text
//! T = 2 int dx / sqrt(2 U),   x = m + r sin phi,   U = (x_0 - x)(x - x_1) g(x)   ->   T = 2 int dphi / sqrt(2 g)
//! ```
//!
//! The last integrand is smooth between the corners and narrow places of the force, at which it is cut. `U` near either end is
//! the mean of the force from there, so nothing cancels.
//!
//! Any other periodic motion: the Runge-Kutta return to a turning point.

use std::f64::consts::FRAC_PI_2;

use crate::numeric::ode::quadrature::{QuadratureError, integrate_smooth, nodes_and_weights};
use crate::numeric::ode::root::{RootError, find_root};
use crate::numeric::ode::{Event, IntegrationError, Options, State, StopReason, Trajectory, integrate};

/// Relative tolerance of the quadratures.
const TOLERANCE: f64 = 1e-14;

/// Relative tolerance where there are many of them.
const TOLERANCE_OF_PIECES: f64 = 1e-12;

/// Harmonics of the exact motion.
const HARMONICS: usize = 64;

/// Tolerance per step of the Runge-Kutta runs that find a return.
const STEP_TOLERANCE: f64 = 1e-13;

/// Why there is no period.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PeriodError {
    /// Released there, the motion leaves instead of swinging.
    #[error(
        "no periodic motion about x = {equilibrium}: released at rest from x = {start}, the force does not pull back there"
    )]
    PushedAway {
        /// The release point.
        start: f64,
        /// The equilibrium.
        equilibrium: f64,
    },
    /// The motion turns before it reaches the equilibrium.
    #[error(
        "no motion about x = {equilibrium}: released at rest from x = {start} it turns back before it gets there, and swings about another equilibrium"
    )]
    OtherWell {
        /// The release point.
        start: f64,
        /// The equilibrium.
        equilibrium: f64,
    },
    /// No second turning point.
    #[error(
        "no periodic motion: released at rest from x = {start}, the motion does not turn back before x = {searched:.2e}"
    )]
    Escapes {
        /// The release point.
        start: f64,
        /// How far the search went.
        searched: f64,
    },
    /// A place in the way that no motion passes.
    #[error("the motion runs into x = {place}, where the force has no finite value")]
    Pole {
        /// Where.
        place: f64,
    },
    /// The force is beyond all numbers where the motion leads.
    #[error("the force overflows at x = {place:e}: `{term}` is beyond the range of double precision, 1.8e308")]
    Overflow {
        /// Where.
        place: f64,
        /// What is beyond, in words.
        term: String,
    },
    /// The force changes so often along the motion that its period would take too long.
    #[error("the force changes too often along this motion for its period to be computed")]
    Waves,
    /// The motion did not come back within the time allowed.
    #[error("no return to a turning point within t = {0}")]
    NoReturn(f64),
    /// A quadrature failed.
    #[error(transparent)]
    Quadrature(#[from] QuadratureError),
    /// A root was lost.
    #[error(transparent)]
    Root(#[from] RootError),
    /// The integration failed.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
}

impl PeriodError {
    /// The same where positions were distances from `origin`.
    #[must_use]
    pub fn moved(self, origin: f64) -> Self {
        match self {
            Self::PushedAway { start, equilibrium } => Self::PushedAway {
                start: start + origin,
                equilibrium: equilibrium + origin,
            },
            Self::OtherWell { start, equilibrium } => Self::OtherWell {
                start: start + origin,
                equilibrium: equilibrium + origin,
            },
            Self::Escapes { start, searched } => Self::Escapes {
                start: start + origin,
                searched: searched + origin,
            },
            Self::Pole { place } => Self::Pole { place: place + origin },
            Self::Overflow { place, term } => Self::Overflow {
                place: place + origin,
                term,
            },
            Self::Waves | Self::NoReturn(_) | Self::Quadrature(_) | Self::Root(_) | Self::Integration(_) => self,
        }
    }
}

/// A force of the position alone, and where it may turn fast.
#[derive(Clone, Copy)]
pub struct Force<'a> {
    value: &'a dyn Fn(f64) -> f64,
    cuts: &'a dyn Fn(f64, f64) -> Vec<f64>,
}

impl<'a> Force<'a> {
    /// A force without corners or bumps narrower than the motion.
    pub fn smooth(value: &'a dyn Fn(f64) -> f64) -> Self {
        Self {
            value,
            cuts: &|_, _| vec![],
        }
    }

    /// A force, and the places strictly between two positions at which to cut, in order: what lies between two cuts is
    /// smooth and no narrower than its distance.
    pub fn with_cuts(value: &'a dyn Fn(f64) -> f64, cuts: &'a dyn Fn(f64, f64) -> Vec<f64>) -> Self {
        Self { value, cuts }
    }

    /// The force at a position.
    pub fn at(&self, x: f64) -> f64 {
        (self.value)(x)
    }

    /// Both ends and the cuts between them, from one end to the other.
    fn knots(&self, from: f64, to: f64) -> Vec<f64> {
        let mut knots = vec![from];
        let cuts = (self.cuts)(from.min(to), from.max(to));
        if from < to {
            knots.extend(cuts);
        } else {
            knots.extend(cuts.into_iter().rev());
        }
        knots.push(to);
        knots
    }
}

/// The period of `x'' + force(x) = 0` released at rest from `start`, swinging about `equilibrium`.
///
/// # Errors
/// See [`PeriodError`].
///
/// ```
/// use lindstedt::numeric::period::{Force, conservative_period};
///
/// let period = conservative_period(&Force::smooth(&f64::sin), 0.0, 1.5)?; // a pendulum, rad
/// assert!((std::f64::consts::TAU / period - 0.860_608_346_679_613).abs() < 1e-12);
/// # Ok::<(), lindstedt::numeric::period::PeriodError>(())
/// ```
pub fn conservative_period(force: &Force, equilibrium: f64, start: f64) -> Result<f64, PeriodError> {
    period_between(force, start, turning_point(force, equilibrium, start)?)
}

/// The period of the motion between two turning points.
///
/// # Errors
/// See [`PeriodError`].
pub fn period_between(force: &Force, start: f64, end: f64) -> Result<f64, PeriodError> {
    period_of_rates(&Rates::new(force, &|_| 1.0, start, end)?)
}

/// `T = 2 int (dt/dphi) dphi`, piece by piece.
fn period_of_rates(rates: &Rates) -> Result<f64, PeriodError> {
    let (mut half, mut estimate) = (0.0, 0.0);
    for piece in 0..rates.angles.len() - 1 {
        let mut failure = None;
        let integrand = |phi: f64| match rates.time_per_angle(piece, phi) {
            Ok(value) => value,
            Err(error) => {
                failure = Some(error);
                f64::NAN
            }
        };
        match integrate_smooth(
            integrand,
            rates.angles[piece],
            rates.angles[piece + 1],
            rates.tolerance(),
        ) {
            Ok((value, error)) => (half, estimate) = (half + value, estimate + error),
            // The force itself is rounded where it is a small difference, as x^2 - 4 near x = 2: no panel gets below that.
            Err(QuadratureError::NotConverged {
                value, error_estimate, ..
            }) => (half, estimate) = (half + value, estimate + error_estimate),
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

/// `dt/dphi = 1/sqrt(2 g)` of the substitution above, piece by piece between the cuts of the force.
struct Rates<'a> {
    force: &'a Force<'a>,
    /// By how much longer an instant takes than without inertia of position.
    weight: &'a dyn Fn(f64) -> f64,
    /// From the far turning point to the start.
    knots: Vec<f64>,
    /// phi at the knots, from -pi/2 to pi/2.
    angles: Vec<f64>,
    /// `V(start) - V` at the knots, added up from either end.
    below_start: Vec<f64>,
    below_end: Vec<f64>,
}

impl<'a> Rates<'a> {
    fn new(force: &'a Force<'a>, weight: &'a dyn Fn(f64) -> f64, start: f64, end: f64) -> Result<Self, PeriodError> {
        let knots = resolved(force, force.knots(end, start))?;
        // A single piece needs no sums.
        let pieces = knots.windows(2).filter(|_| knots.len() > 2);
        let pieces = pieces.map(|pair| integral(force.value, pair[0], pair[1], 0.0));
        let works = pieces.collect::<Result<Vec<f64>, _>>()?;
        let (mut below_end, mut below_start) = (vec![0.0], vec![0.0]);
        for work in &works {
            below_end.push(below_end[below_end.len() - 1] - work);
        }
        for work in works.iter().rev() {
            below_start.push(below_start[below_start.len() - 1] + work);
        }
        below_start.reverse();
        // By the half angle, so that a knot close to an end keeps its distance from it.
        let angle = |&knot: &f64| {
            let part = (knot - end) / (start - end);
            if part < 0.5 {
                2.0 * part.max(0.0).sqrt().asin() - FRAC_PI_2
            } else {
                FRAC_PI_2 - 2.0 * (1.0 - part).max(0.0).sqrt().asin()
            }
        };
        Ok(Self {
            force,
            weight,
            angles: knots.iter().map(angle).collect(),
            knots,
            below_start,
            below_end,
        })
    }

    fn tolerance(&self) -> f64 {
        if self.knots.len() == 2 {
            TOLERANCE
        } else {
            TOLERANCE_OF_PIECES
        }
    }

    fn time_per_angle(&self, piece: usize, phi: f64) -> Result<f64, QuadratureError> {
        let (end, start) = (self.knots[0], self.knots[self.knots.len() - 1]);
        let (low, high) = (self.knots[piece], self.knots[piece + 1]);
        let mean_force = |from: f64, to: f64| integral(&|u| self.force.at(from + (to - from) * u), 0.0, 1.0, 0.0);
        // From the nearer end: beside a pole the distance from it counts, not the position.
        let x = match phi >= 0.0 {
            true => start - (start - end) * (0.5 * (FRAC_PI_2 - phi)).sin().powi(2),
            false => end + (start - end) * (0.5 * (FRAC_PI_2 + phi)).sin().powi(2),
        };
        let single = self.knots.len() == 2;
        let x = if single {
            x
        } else {
            x.clamp(low.min(high), low.max(high))
        };
        // From the nearer end, so that nothing cancels; in the outermost piece the distance from that end cancels exactly.
        let quotient = if phi >= 0.0 && piece + 2 == self.knots.len() {
            mean_force(x, start)? / (x - end)
        } else if phi < 0.0 && piece == 0 {
            -mean_force(end, x)? / (start - x)
        } else {
            let energy = if phi >= 0.0 {
                self.below_start[piece + 1] + (high - x) * mean_force(x, high)?
            } else {
                self.below_end[piece] - (x - low) * mean_force(low, x)?
            };
            let span = (start - end).powi(2);
            energy / (span * (0.5 * (FRAC_PI_2 - phi)).sin().powi(2) * (0.5 * (FRAC_PI_2 + phi)).sin().powi(2))
        };
        Ok((self.weight)(x) / (2.0 * quotient).sqrt())
    }
}

/// The period of a motion where the energy is `M x'^2/2 + U`, released at rest from `start`, and the coefficients of
/// `cos(k theta)`: `force` is `U'` and `weight` the root of `M`, by which every instant takes longer.
///
/// # Errors
/// See [`PeriodError`].
///
/// ```
/// use lindstedt::numeric::period::{Force, weighted_motion};
///
/// // (1 + x^2)*x'' + x*x'^2 + x = 0 has the energy (1 + x^2) x'^2/2 + x^2/2.
/// let (period, cosines) = weighted_motion(&Force::smooth(&|x| x), &|x| (1.0 + x * x).sqrt(), 0.0, 0.1)?;
/// assert!(period > std::f64::consts::TAU && (cosines.iter().sum::<f64>() - 0.1).abs() < 1e-9);
/// # Ok::<(), lindstedt::numeric::period::PeriodError>(())
/// ```
pub fn weighted_motion(
    force: &Force,
    weight: &dyn Fn(f64) -> f64,
    equilibrium: f64,
    start: f64,
) -> Result<(f64, Vec<f64>), PeriodError> {
    motion_between(force, weight, start, turning_point(force, equilibrium, start)?)
}

/// The period and the coefficients of `cos(k theta)` of the motion between two turning points, the first at `theta = 0`.
///
/// With `psi = pi/2 - phi` the rate `h = dt/dpsi` is an even, periodic function: its cosine series gives `omega t(psi)`, and
/// sums over equal steps in `psi` give the coefficients, both to spectral accuracy for a smooth force. Where the force has
/// corners or narrow places the same integrals are taken piece by piece.
///
/// # Errors
/// See [`PeriodError`].
pub fn motion_between(
    force: &Force,
    weight: &dyn Fn(f64) -> f64,
    start: f64,
    end: f64,
) -> Result<(f64, Vec<f64>), PeriodError> {
    const FEWEST: usize = 64;
    const MOST: usize = 1024;
    let rates = Rates::new(force, weight, start, end)?;
    if rates.knots.len() > 2 {
        return motion_by_pieces(&rates, period_of_rates(&rates)?);
    }
    let pi = std::f64::consts::PI;
    let (mut points, mut last) = (FEWEST, f64::INFINITY);
    loop {
        let angle = |i: usize| pi * (i as f64 + 0.5) / points as f64;
        let values: Vec<f64> = (0..points)
            .map(|i| rates.time_per_angle(0, 0.5 * pi - angle(i)))
            .collect::<Result<_, _>>()?;
        let mean = values.iter().sum::<f64>() / points as f64;
        let settled = (mean - last).abs() <= 1e-13 * mean;
        if !settled && points < MOST {
            (points, last) = (2 * points, mean);
            continue;
        }
        if (mean - last).abs() > 1e-9 * mean {
            return motion_by_pieces(&rates, period_of_rates(&rates)?);
        }
        let kept = points / 2;
        let rate_coefficients: Vec<f64> = (1..kept)
            .map(|j| {
                let sum: f64 = values
                    .iter()
                    .enumerate()
                    .map(|(i, rate)| rate * (j as f64 * angle(i)).cos())
                    .sum();
                2.0 * sum / points as f64
            })
            .collect();
        let theta = |psi: f64| {
            let waves = rate_coefficients
                .iter()
                .zip(1..)
                .map(|(rate, j)| rate * (f64::from(j) * psi).sin() / f64::from(j));
            psi + waves.sum::<f64>() / mean
        };
        let mut coefficients = vec![0.0; HARMONICS];
        for (i, rate) in values.iter().enumerate() {
            let psi = angle(i);
            let (x, theta) = (0.5 * (start + end) + 0.5 * (start - end) * psi.cos(), theta(psi));
            for (k, coefficient) in coefficients.iter_mut().enumerate() {
                let weight = if k == 0 { 1.0 } else { 2.0 } / points as f64;
                *coefficient += weight * x * (k as f64 * theta).cos() * rate / mean;
            }
        }
        return Ok((2.0 * pi * mean, coefficients));
    }
}

/// Period and coefficients by Gauss-Legendre panels in phi: the phase at the points of a panel is the integral of the
/// Legendre series through the rates there. The panels are halved until their time agrees with the period.
fn motion_by_pieces(rates: &Rates, period: f64) -> Result<(f64, Vec<f64>), PeriodError> {
    const HALVINGS: u32 = 6;
    /// The longest panel, as a phase: the highest harmonic still has few waves on it.
    const LONGEST: f64 = 0.2;
    let (end, start) = (rates.knots[0], rates.knots[rates.knots.len() - 1]);
    let frequency = std::f64::consts::TAU / period;
    let mut coefficients = vec![0.0; HARMONICS];
    for halving in 0..=HALVINGS {
        coefficients.fill(0.0);
        // The phase from the far turning point, where it is -pi.
        let mut phase = -std::f64::consts::PI;
        for piece in 0..rates.angles.len() - 1 {
            let (low, high) = (rates.angles[piece], rates.angles[piece + 1]);
            let mut duration = 0.0;
            for (phi, weight) in nodes_and_weights(low, high) {
                duration += weight * rates.time_per_angle(piece, phi)?;
            }
            let parts = (1 + (frequency * duration / LONGEST) as u32) << halving;
            let place = |part: u32| low + (high - low) * f64::from(part) / f64::from(parts);
            for part in 0..parts {
                let (from, to) = (place(part), place(part + 1));
                let nodes: Vec<(f64, f64)> = nodes_and_weights(from, to).collect();
                let values = nodes.iter().map(|node| rates.time_per_angle(piece, node.0));
                let values = values.collect::<Result<Vec<f64>, _>>()?;
                let elapsed = running_integral(&nodes, &values, from, to);
                for ((&(phi, weight), rate), elapsed) in nodes.iter().zip(&values).zip(elapsed) {
                    let theta = phase + frequency * elapsed;
                    let x = 0.5 * (start + end) + 0.5 * (start - end) * phi.sin();
                    for (k, coefficient) in coefficients.iter_mut().enumerate() {
                        let share = if k == 0 { 1.0 } else { 2.0 } / std::f64::consts::PI;
                        *coefficient += share * x * (k as f64 * theta).cos() * rate * frequency * weight;
                    }
                }
                phase += frequency * nodes.iter().zip(&values).map(|(node, rate)| node.1 * rate).sum::<f64>();
            }
        }
        // At the start the phase is zero again.
        if phase.abs() < 1e-10 {
            break;
        }
    }
    Ok((period, coefficients))
}

/// The integral from `from` to each node, through the Legendre series of the values: `int P_l = (P_(l+1) - P_(l-1))/(2l+1)`.
fn running_integral(nodes: &[(f64, f64)], values: &[f64], from: f64, to: f64) -> Vec<f64> {
    let half = 0.5 * (to - from);
    // P_0 to P_n at each node.
    let legendre = |x: f64| {
        let u = (x - 0.5 * (from + to)) / half;
        let mut p = vec![1.0, u];
        for l in 1..nodes.len() {
            let l_real = l as f64;
            p.push(((2.0 * l_real + 1.0) * u * p[l] - l_real * p[l - 1]) / (l_real + 1.0));
        }
        p
    };
    let polynomials: Vec<Vec<f64>> = nodes.iter().map(|node| legendre(node.0)).collect();
    let series: Vec<f64> = (0..nodes.len())
        .map(|l| {
            let terms = nodes.iter().zip(values).zip(&polynomials);
            let sum: f64 = terms.map(|((node, value), p)| node.1 / half * value * p[l]).sum();
            0.5 * (2.0 * l as f64 + 1.0) * sum
        })
        .collect();
    let integral = |p: &Vec<f64>| {
        let higher = (1..nodes.len()).map(|l| series[l] * (p[l + 1] - p[l - 1]) / (2.0 * l as f64 + 1.0));
        half * (series[0] * (p[1] + 1.0) + higher.sum::<f64>())
    };
    polynomials.iter().map(integral).collect()
}

/// Knots so close that the force between two of them is integrated by a few panels, where between these ones it waves too
/// often for many: an integral of its own for every instant would then cost as much as the square of the waves.
///
/// # Errors
/// More knots than can be waited for.
fn resolved(force: &Force, knots: Vec<f64>) -> Result<Vec<f64>, PeriodError> {
    const FEW_PANELS: i32 = 4;
    const MOST_KNOTS: usize = 1 << 14;
    const HALVINGS: u32 = 15;
    let mut found: Vec<f64> = knots.first().copied().into_iter().collect();
    for pair in knots.windows(2) {
        if settled(force.value, pair[0], pair[1], 0.0, MOST_PANELS).is_some() {
            found.push(pair[1]);
            continue;
        }
        let mut open = vec![(pair[0], pair[1], 0)];
        while let Some((from, to, halvings)) = open.pop() {
            if found.len() + open.len() > MOST_KNOTS {
                return Err(PeriodError::Waves);
            }
            if halvings == HALVINGS || settled(force.value, from, to, 0.0, FEW_PANELS).is_some() {
                found.push(to);
                continue;
            }
            let middle = 0.5 * (from + to);
            open.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]);
        }
    }
    Ok(found)
}

/// Panels after which an integral is left to adaptive quadrature.
const MOST_PANELS: i32 = 64;

/// The integral of a force: panels are doubled until the value settles. Errors below `negligible` do not count.
fn integral(function: &dyn Fn(f64) -> f64, from: f64, to: f64, negligible: f64) -> Result<f64, QuadratureError> {
    if let Some(value) = settled(function, from, to, negligible, MOST_PANELS) {
        return Ok(value);
    }
    match integrate_smooth(function, from, to, TOLERANCE) {
        // Where pull and push cancel, the integral is as good as the forces in it allow.
        Err(QuadratureError::NotConverged {
            value, error_estimate, ..
        }) if error_estimate <= f64::max(1e-11 * size(function, from, to), negligible) => Ok(value),
        result => result.map(|(value, _)| value),
    }
}

/// The value at which the integral settles while panels are doubled, or from which on doubling no longer brings it closer, which is
/// where the rounding of the force itself begins.
fn settled(function: &dyn Fn(f64) -> f64, from: f64, to: f64, negligible: f64, most_panels: i32) -> Option<f64> {
    let with_panels = |panels: i32| {
        let place = |k: i32| from + (to - from) * f64::from(k) / f64::from(panels);
        let nodes = (0..panels).flat_map(|k| nodes_and_weights(place(k), place(k + 1)));
        nodes.map(|(x, weight)| weight * function(x)).sum::<f64>()
    };
    let (mut value, mut change) = (with_panels(1), f64::INFINITY);
    let mut panels = 2;
    while panels <= most_panels {
        let finer = with_panels(panels);
        let next = (finer - value).abs();
        if next <= f64::max(TOLERANCE * finer.abs(), negligible) || (next >= 0.5 * change && next <= 1e-9 * finer.abs())
        {
            return Some(finer);
        }
        (value, change) = (finer, next);
        panels *= 2;
    }
    None
}

/// The integral of the size of a function, roughly.
fn size(function: &dyn Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let nodes = nodes_and_weights(from, to);
    nodes.map(|(x, weight)| (weight * function(x)).abs()).sum()
}

/// The other turning point of a conservative motion released at rest from `start`.
///
/// # Errors
/// See [`PeriodError`].
///
/// ```
/// use lindstedt::numeric::period::{Force, turning_point};
///
/// let end = turning_point(&Force::smooth(&|x| x + 0.5 * x * x), 0.0, 0.5)?;
/// let energy = |x: f64| x * x / 2.0 + x.powi(3) / 6.0;
/// assert!(end < -0.5 && (energy(end) - energy(0.5)).abs() < 1e-12);
/// # Ok::<(), lindstedt::numeric::period::PeriodError>(())
/// ```
pub fn turning_point(force: &Force, equilibrium: f64, start: f64) -> Result<f64, PeriodError> {
    /// Steps per window of the search, and how many amplitudes far it goes.
    const STEPS: usize = 64;
    const FARTHEST: f64 = 1e10;
    /// How often a stretch on which the force has no integral is halved.
    const HALVINGS: u32 = 60;
    let amplitude = start - equilibrium;
    let side = amplitude.signum();
    if force.at(start) * side <= 0.0 || amplitude == 0.0 {
        return Err(PeriodError::PushedAway { start, equilibrium });
    }
    if is_symmetric(force, equilibrium, amplitude) {
        return Ok(equilibrium - amplitude);
    }
    // Against the largest energy on the way, errors below the last digit are none.
    let gained = |from: f64, to: f64, largest: f64| integral(force.value, to, from, 0.5 * f64::EPSILON * largest);
    // Windows of growing length: to the mirror image of the start, as far again, twice as far, ...
    let (mut x, mut energy, mut largest, mut window) = (start, 0.0, 0.0, 2.0 * amplitude.abs());
    while (x - equilibrium).abs() < FARTHEST * amplitude.abs() {
        let from = x;
        let mut places = force.knots(from, from - side * window);
        places.extend((1..STEPS).map(|k| from - side * window * k as f64 / STEPS as f64));
        places.sort_by(|one, other| (side * other).total_cmp(&(side * one)));
        places.dedup();
        for pair in places.windows(2) {
            let mut stretches = where_it_turns(force, side, pair[0], pair[1]);
            stretches.reverse();
            let mut halvings = 0;
            while let Some((here, next)) = stretches.pop() {
                let gain = match gained(here, next, largest) {
                    // Towards a pole, by half of the way at a time.
                    Err(_) if halvings < HALVINGS => {
                        halvings += 1;
                        let middle = 0.5 * (here + next);
                        stretches.extend([(middle, next), (here, middle)]);
                        continue;
                    }
                    gain => gain?,
                };
                let after = energy + gain;
                if after <= 0.0 {
                    let mut failure = None;
                    let root = find_root(
                        |candidate| match gained(here, candidate, largest) {
                            Ok(gain) => energy + gain,
                            Err(error) => {
                                failure = Some(error);
                                f64::NAN
                            }
                        },
                        here,
                        next,
                    );
                    let end = root.map_err(|error| failure.map_or(error.into(), PeriodError::from))?;
                    return match (end - equilibrium) * amplitude > 0.0 {
                        true => Err(PeriodError::OtherWell { start, equilibrium }),
                        false => Ok(end),
                    };
                }
                energy = after;
                largest = f64::max(largest, energy);
            }
        }
        x = places[places.len() - 1];
        window = f64::max(window, (x - equilibrium).abs());
    }
    Err(PeriodError::Escapes { start, searched: x })
}

/// Whether the well is symmetric and has a single bottom as far as the amplitude. The mirror image of the start is then the
/// turning point to the last digit, which no root finder gives near a separatrix.
fn is_symmetric(force: &Force, equilibrium: f64, amplitude: f64) -> bool {
    let mut places: Vec<f64> = (1..=16).map(|k| amplitude * f64::from(k) / 16.0).collect();
    let knots = force.knots(equilibrium - amplitude, equilibrium + amplitude);
    places.extend(knots.iter().map(|knot| knot - equilibrium));
    places.extend(knots.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]) - equilibrium));
    places.into_iter().filter(|&x| x != 0.0).all(|x| {
        let (here, there) = (force.at(equilibrium + x), force.at(equilibrium - x));
        here == -there && here * x.signum() > 0.0
    })
}

/// A step cut where the force first pushes the motion back and then on again, so that the kinetic energy has no lowest point
/// between two ends.
fn where_it_turns(force: &Force, side: f64, from: f64, to: f64) -> Vec<(f64, f64)> {
    const SAMPLES: usize = 4;
    let place = |k: usize| from + (to - from) * k as f64 / SAMPLES as f64;
    let drives: Vec<bool> = (1..SAMPLES).map(|k| force.at(place(k)) * side > 0.0).collect();
    if drives.windows(2).all(|pair| pair[0] || !pair[1]) {
        return vec![(from, to)];
    }
    (0..SAMPLES)
        .map(|k| (place(k), if k + 1 == SAMPLES { to } else { place(k + 1) }))
        .collect()
}

/// A motion from one turning point to the next on the same side, in the units of the equation.
///
/// Runge-Kutta compares its errors with absolute numbers, so the path is kept in units of the amplitude and of the time
/// `sqrt(amplitude/acceleration)`.
#[derive(Clone, Debug)]
pub struct Swing {
    path: Trajectory,
    equilibrium: f64,
    length: f64,
    time: f64,
}

impl Swing {
    /// The same where positions were distances from `origin`.
    #[must_use]
    pub fn moved(mut self, origin: f64) -> Self {
        self.equilibrium += origin;
        self
    }

    /// The time of the swing.
    pub fn period(&self) -> f64 {
        self.path.end().t * self.time
    }

    /// Position and velocity at a time from zero to the period.
    pub fn at(&self, t: f64) -> Option<(f64, f64)> {
        let (x, v) = self.path.at((t / self.time).min(self.path.end().t))?;
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

/// As [`swing`], restarted at every cut, so that no step jumps over a corner or a narrow place of the force.
///
/// # Errors
/// See [`PeriodError`].
///
/// ```
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
    let state = State {
        t: 0.0,
        x: (start - equilibrium) / length,
        v: 0.0,
    };
    let turning = Event::stop(|_, _, v| v);
    let turning = if start > equilibrium {
        turning.falling()
    } else {
        turning.rising()
    };
    let at_cut = |cut: f64| {
        let cut = (cut - equilibrium) / length;
        Event::switch(
            move |_, x, _| x - cut,
            move |state: State| (0, State { x: cut, ..state }),
        )
    };
    let events: Vec<Event> = std::iter::once(turning)
        .chain(cuts.iter().map(|&cut| at_cut(cut)))
        .collect();
    let path = integrate(
        scaled,
        state,
        longest / time,
        &events,
        &Options::with_tolerance(STEP_TOLERANCE),
    )?;
    let swing = Swing {
        path,
        equilibrium,
        length,
        time,
    };
    match swing.path.stop_reason() {
        StopReason::Event { .. } => Ok(swing),
        _ => Err(PeriodError::NoReturn(swing.end().t)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn period_of(force: &dyn Fn(f64) -> f64, equilibrium: f64, start: f64) -> Result<f64, PeriodError> {
        conservative_period(&Force::smooth(force), equilibrium, start)
    }

    #[test]
    fn pendulum_and_duffing_by_elliptic_functions() {
        for amplitude in [0.01, 0.5, 1.5, 2.5, 3.0, 3.13, -1.5] {
            let period = period_of(&|x: f64| x.sin(), 0.0, amplitude).unwrap();
            // By the complementary parameter 1 - m = cos^2(A/2): near the separatrix m itself has lost its digits.
            let exact = 4.0 * spec_math::cephes64::ellpk((0.5 * amplitude).cos().powi(2));
            assert!(
                (period / exact - 1.0).abs() < 1e-13,
                "A = {amplitude}: {period} {exact}"
            );
        }
        for s in [-0.9, 0.1, 1.0, 10.0, 1000.0] {
            let period = period_of(&|x: f64| x + s * x * x * x, 0.0, 1.0).unwrap();
            let exact = 4.0 * ellip::ellipk(s / (2.0 * (1.0 + s))).unwrap() / f64::sqrt(1.0 + s);
            assert!((period / exact - 1.0).abs() < 1e-13, "s = {s}: {period} {exact}");
        }
    }

    #[test]
    fn an_uneven_well_has_its_own_turning_point() {
        // V = x^2/2 + x^3/3 at x = 1/4: V(x_1) = V(1/4) is a cubic with root 1/4, leaving a quadratic.
        let end = turning_point(&Force::smooth(&|x: f64| x + x * x), 0.0, 0.25).unwrap();
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
        assert!(matches!(
            period_of(&cubic, 0.0, 2.5),
            Err(PeriodError::PushedAway { .. })
        ));
        assert!(matches!(
            period_of(&|x: f64| x + x * x, 0.0, 0.75),
            Err(PeriodError::Escapes { .. })
        ));
    }

    #[test]
    fn a_motion_in_another_well_is_told_from_one_over_all() {
        let wells = |x: f64| x - x.powi(3) + 0.2 * x.powi(5);
        assert!(matches!(
            conservative_period(&Force::smooth(&wells), 0.0, 2.0),
            Err(PeriodError::OtherWell { .. })
        ));
        assert!((turning_point(&Force::smooth(&wells), 0.0, 2.5).unwrap() + 2.5).abs() < 1e-14);
        let uneven = |x: f64| wells(x) + 0.01;
        assert!(matches!(
            conservative_period(&Force::smooth(&uneven), -0.01, -2.0),
            Err(PeriodError::OtherWell { .. })
        ));
    }
}

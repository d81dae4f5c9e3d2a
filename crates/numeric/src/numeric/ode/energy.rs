//! Conservative motion by its energy: the second turning point, and the time from one turning point
//! to the other as the integral of a smooth function. The judge and the method `exact` each
//! integrate it on their own.
//!
//! Reference: L. D. Landau and E. M. Lifshitz, *Mechanics*, 3rd ed., section 11. Between the
//! turning points `x_0` and `x_1`, with `U(x) = V(x_0) - V(x)`,
//!
//! ```text
//! T = 2 int dx / sqrt(2 U),   x = m + r sin phi,   U = (x_0 - x)(x - x_1) g(x)   ->   T = 2 int dphi / sqrt(2 g)
//! ```
//!
//! The last integrand is smooth between the corners and narrow places of the force, at which it is
//! cut. `U` near either end is the mean of the force from there, so nothing cancels. A force that
//! is infinite in the middle of a symmetric motion, as `1/x` or `sgn(x)/sqrt(abs(x))`, is cut at
//! distances of equal ratio towards it; each `U` is counted from the end on its own side, so that
//! none goes through the middle, where that of `1/x` is infinite and `dt/dphi` zero.

use std::cell::Cell;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

use super::IntegrationError;
use super::mean_value::{IntervalEnd, MOST_TERMS, MeanValues};
use super::quadrature::{QuadratureError, integrate_within, nodes_and_weights};
use super::root::{RootError, find_root};

/// Relative tolerance of the quadratures.
const TOLERANCE: f64 = 1e-14;

/// Relative tolerance of each quadrature if the motion is cut into pieces.
const TOLERANCE_OF_PIECES: f64 = 1e-12;

/// The reason why there is no period.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PeriodError {
    /// The force at the release point does not pull the motion back.
    #[error(
        "no periodic motion about x = {equilibrium}: released at rest from x = {start}, the force does not pull back there{}",
        periodic_elsewhere(range)
    )]
    PushedAway {
        /// The release point.
        start: f64,
        /// The equilibrium.
        equilibrium: f64,
        /// The range of periodic motions, in words.
        range: Option<String>,
    },
    /// The motion turns before it reaches the equilibrium.
    #[error(
        "no motion about x = {equilibrium}: released at rest from x = {start} it turns back before it gets there, and swings about another equilibrium{}",
        periodic_elsewhere(range)
    )]
    OtherWell {
        /// The release point.
        start: f64,
        /// The equilibrium.
        equilibrium: f64,
        /// The range of periodic motions, in words.
        range: Option<String>,
    },
    /// The motion is too small to pass the unstable equilibrium about which it should swing.
    #[error(
        "no motion through x = {equilibrium}: released at rest from x = {start} it stays in one well, and it needs an amplitude above {least}"
    )]
    OneWell {
        /// The release point.
        start: f64,
        /// The unstable equilibrium.
        equilibrium: f64,
        /// The least amplitude, to six digits.
        least: f64,
    },
    /// There is no second turning point.
    #[error(
        "no periodic motion: released at rest from x = {start}, the motion does not turn back before x = {searched:.2e}{}",
        periodic_elsewhere(range)
    )]
    Escapes {
        /// The release point.
        start: f64,
        /// The position that the search has reached.
        searched: f64,
        /// The range of periodic motions, in words.
        range: Option<String>,
    },
    /// The speed grows without bound, faster than the force at rest could make it grow.
    #[error(
        "no periodic motion: released at rest from x = {start}, the motion runs away: its speed grows beyond all bounds by t = {time}"
    )]
    RunsAway {
        /// The release point.
        start: f64,
        /// The time by which it does so, to six digits.
        time: f64,
    },
    /// The motion is released outside the range of periodic motions, and the error that describes
    /// it has no place for that range.
    #[error("{error}; motions are {range}")]
    OutsideWell {
        /// The fate of this motion.
        error: Box<PeriodError>,
        /// The range of periodic motions, in words.
        range: String,
    },
    /// The release is on the separatrix, to double precision.
    #[error(
        "no periodic motion: released at rest from x = {start}, it is on the separatrix of the unstable equilibrium x = {place}, and \
         never comes back"
    )]
    Separatrix {
        /// The release point.
        start: f64,
        /// The unstable equilibrium.
        place: f64,
    },
    /// The release is so close to the separatrix that rounding decides how long the motion stays
    /// there.
    #[error(
        "released at rest from x = {start}, the motion is too close to the separatrix of the unstable equilibrium x = {place} for its \
         period to be computed: on the separatrix it never comes back"
    )]
    NearSeparatrix {
        /// The release point.
        start: f64,
        /// The unstable equilibrium.
        place: f64,
    },
    /// The motion runs into a pole of the force.
    #[error("the motion runs into x = {place}, where the force has no finite value")]
    Pole {
        /// The position.
        place: f64,
    },
    /// The force overflows f64 on the way of the motion.
    #[error(
        "the force overflows at x = {place:e}: `{term}` is beyond the range of double precision, 1.8e308"
    )]
    Overflow {
        /// The position.
        place: f64,
        /// The part of the force that overflows, in words.
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
    /// A root search failed.
    #[error(transparent)]
    Root(#[from] RootError),
    /// The integration failed.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
}

/// Returns the end of a message that names the range of periodic motions; empty if it is not known.
fn periodic_elsewhere(range: &Option<String>) -> String {
    range.as_ref().map_or_else(String::new, |range| format!("; motions are {range}"))
}

impl PeriodError {
    /// Returns the error with the range of periodic motions, in words.
    #[must_use]
    pub fn with_range(mut self, words: String) -> Self {
        match &mut self {
            Self::PushedAway { range, .. }
            | Self::OtherWell { range, .. }
            | Self::Escapes { range, .. } => {
                *range = Some(words);
                self
            }
            _ => Self::OutsideWell { error: Box::new(self), range: words },
        }
    }

    /// Returns the error with `origin` added to all positions.
    #[must_use]
    pub fn moved(mut self, origin: f64) -> Self {
        match &mut self {
            Self::PushedAway { start, equilibrium: other, .. }
            | Self::OtherWell { start, equilibrium: other, .. }
            | Self::OneWell { start, equilibrium: other, .. }
            | Self::Escapes { start, searched: other, .. }
            | Self::Separatrix { start, place: other }
            | Self::NearSeparatrix { start, place: other } => {
                *start += origin;
                *other += origin;
            }
            Self::RunsAway { start: place, .. }
            | Self::Pole { place }
            | Self::Overflow { place, .. } => *place += origin,
            Self::OutsideWell { error, .. } => **error = error.as_ref().clone().moved(origin),
            Self::Waves
            | Self::NoReturn(_)
            | Self::Quadrature(_)
            | Self::Root(_)
            | Self::Integration(_) => {}
        }
        self
    }
}

/// A force that depends on the position alone, and the cuts between which it is smooth.
#[derive(Clone, Copy)]
pub struct PiecewiseForce<'a> {
    value: &'a dyn Fn(f64) -> f64,
    cuts: &'a dyn Fn(f64, f64) -> Vec<f64>,
}

impl<'a> PiecewiseForce<'a> {
    /// A force without corners or bumps narrower than the motion.
    pub fn smooth(value: &'a dyn Fn(f64) -> f64) -> Self {
        Self { value, cuts: &|_, _| vec![] }
    }

    /// A force, and a function that returns the cuts strictly between two positions in increasing
    /// order. Between neighbouring cuts the force is smooth on the scale of their distance.
    pub fn with_cuts(
        value: &'a dyn Fn(f64) -> f64,
        cuts: &'a dyn Fn(f64, f64) -> Vec<f64>,
    ) -> Self {
        Self { value, cuts }
    }

    /// The force at a position.
    pub fn value_at(&self, x: f64) -> f64 {
        (self.value)(x)
    }

    /// Returns both ends and the cuts between them, in order from `from` to `to`.
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

/// `dt/dphi = 1/sqrt(2 g)` of the substitution in the module's documentation, piece by piece
/// between the cuts of the force.
pub struct TimePerAngle<'a> {
    force: &'a PiecewiseForce<'a>,
    /// Time dilation sqrt(M(x)) of a position-dependent mass, 1 if the mass is constant.
    weight: &'a dyn Fn(f64) -> f64,
    /// Positions from the far turning point to the start.
    pub knots: Vec<f64>,
    /// phi at the knots, from -pi/2 to pi/2.
    pub angles: Vec<f64>,
    /// Whether the force is infinite in the middle.
    infinite_middle: bool,
    /// `V(start) - V` at the knots, summed from the start and from the far turning point.
    below_start: Vec<f64>,
    below_end: Vec<f64>,
    /// The means of the force from both ends of each piece, where it has a series there.
    means: Vec<Option<MeanValues>>,
}

impl<'a> TimePerAngle<'a> {
    /// The integrand between two turning points, the first of them the start.
    ///
    /// # Errors
    /// [`PeriodError`] if the force has no finite integral between them or changes too often.
    pub fn new(
        force: &'a PiecewiseForce<'a>,
        weight: &'a dyn Fn(f64) -> f64,
        start: f64,
        end: f64,
    ) -> Result<Self, PeriodError> {
        let infinite_middle = start == -end && grows_towards_zero(force.value, start);
        let knots = match infinite_middle {
            false => force.knots(end, start),
            true => graded(&force.knots(end, start)),
        };
        // At a turning point the mean divides, elsewhere it is added to an energy.
        let series = |pair: &[f64], most: usize| match infinite_middle {
            true => None,
            false => {
                let turning = [pair[0] == end, pair[1] == start];
                MeanValues::new(force.value, [pair[0], pair[1]], turning, most)
            }
        };
        let (knots, means) = resolved(force, &knots, infinite_middle, &series)?;
        // A single piece needs no sums.
        let pieces = knots.windows(2).zip(&means).filter(|_| knots.len() > 2);
        let pieces = pieces.map(|(pair, means)| match means {
            // This value is never used, as no energy is counted through the middle.
            _ if infinite_middle && pair.contains(&0.0) => Ok(f64::NAN),
            Some(means) if means.power_at().is_some() => Ok((pair[1] - pair[0]) * means.mean()),
            _ => integral(force.value, pair[0], pair[1], 0.0),
        });
        let works = pieces.collect::<Result<Vec<f64>, _>>()?;
        let (mut below_end, mut below_start) = (vec![0.0], vec![0.0]);
        for work in &works {
            below_end.push(below_end[below_end.len() - 1] - work);
        }
        for work in works.iter().rev() {
            below_start.push(below_start[below_start.len() - 1] + work);
        }
        below_start.reverse();
        // With cos or sin of the half angle, so that the distance of a knot from the nearer end
        // keeps its digits; near an infinite middle the distance from zero counts instead.
        let angle = |&knot: &f64| {
            let part = (knot - end) / (start - end);
            if infinite_middle && part > 0.25 && part < 0.75 {
                (knot / start).asin()
            } else if part < 0.5 {
                2.0 * part.max(0.0).sqrt().asin() - FRAC_PI_2
            } else {
                FRAC_PI_2 - 2.0 * (1.0 - part).max(0.0).sqrt().asin()
            }
        };
        Ok(Self {
            force,
            weight,
            means,
            angles: knots.iter().map(angle).collect(),
            knots,
            infinite_middle,
            below_start,
            below_end,
        })
    }

    /// Returns the relative tolerance of the integral of `dt/dphi` over one of the pieces.
    pub fn tolerance(&self, piece: usize) -> f64 {
        /// The loosest tolerance, for a piece that adds next to nothing.
        const ROUGH: f64 = 1e-2;
        let ends = [self.knots[piece], self.knots[piece + 1]];
        if self.knots.len() == 2 {
            TOLERANCE
        } else if self.infinite_middle && ends.contains(&0.0) {
            // The motion is nowhere faster: the piece adds less to the period than its share of the
            // angles.
            let share = (self.angles[piece + 1] - self.angles[piece]) / std::f64::consts::PI;
            (TOLERANCE_OF_PIECES / share).min(ROUGH)
        } else {
            TOLERANCE_OF_PIECES
        }
    }

    /// Returns the range of the variable in which `dt/dphi` is integrated over one of the pieces:
    /// the angle itself, or, next to a power of the force, the cube root of the distance from the
    /// angle there. The integrand is smooth enough in it that two panels do where a hundred would be
    /// needed in the angle.
    pub fn variable_range(&self, piece: usize) -> [f64; 2] {
        match self.power_at(piece) {
            None => [self.angles[piece], self.angles[piece + 1]],
            Some(_) => [0.0, 1.0],
        }
    }

    /// Returns the angle at a value of the [variable](Self::variable_range) of one of the pieces, and
    /// its rate of change with that.
    pub fn angle_at(&self, piece: usize, variable: f64) -> (f64, f64) {
        let [from, to] = [self.angles[piece], self.angles[piece + 1]];
        let slope = |distance: f64| 3.0 * distance * distance * (to - from);
        match self.power_at(piece) {
            None => (variable, 1.0),
            Some(IntervalEnd::First) => (from + (to - from) * variable.powi(3), slope(variable)),
            Some(IntervalEnd::Last) => {
                let distance = 1.0 - variable;
                (to - (to - from) * distance.powi(3), slope(distance))
            }
        }
    }

    /// The end of a piece at which the force is a power of the distance.
    fn power_at(&self, piece: usize) -> Option<IntervalEnd> {
        self.means[piece].as_ref()?.power_at()
    }

    /// Returns `dt/dphi` in one of the pieces.
    ///
    /// # Errors
    /// [`QuadratureError`] if the force has no finite integral there.
    pub fn time_per_angle(&self, piece: usize, phi: f64) -> Result<f64, QuadratureError> {
        let (end, start) = (self.knots[0], self.knots[self.knots.len() - 1]);
        let (low, high) = (self.knots[piece], self.knots[piece + 1]);
        let by_quadrature = |from: f64, to: f64| {
            integral(&|u| self.force.value_at(from + (to - from) * u), 0.0, 1.0, 0.0)
        };
        // Both between a position and an end of the piece.
        let mean_from_low = |x: f64| match &self.means[piece] {
            Some(means) => Ok(means.since_first(x)),
            None => by_quadrature(low, x),
        };
        let mean_to_high = |x: f64| match &self.means[piece] {
            Some(means) => Ok(means.until_last(x)),
            None => by_quadrature(x, high),
        };
        // The position from the nearer end, or from an infinite middle: beside a pole the distance
        // from it must keep its digits, not the position.
        let x = match phi >= 0.0 {
            _ if self.infinite_middle && phi.abs() < FRAC_PI_6 => start * phi.sin(),
            true => start - (start - end) * (0.5 * (FRAC_PI_2 - phi)).sin().powi(2),
            false => end + (start - end) * (0.5 * (FRAC_PI_2 + phi)).sin().powi(2),
        };
        let single = self.knots.len() == 2;
        let x = if single { x } else { x.clamp(low.min(high), low.max(high)) };
        // The energy from the nearer end, so that nothing cancels; in the outermost piece the
        // distance from that end divides out.
        let quotient = if phi >= 0.0 && piece + 2 == self.knots.len() {
            mean_to_high(x)? / (x - end)
        } else if phi < 0.0 && piece == 0 {
            -mean_from_low(x)? / (start - x)
        } else {
            let energy = if phi >= 0.0 {
                self.below_start[piece + 1] + (high - x) * mean_to_high(x)?
            } else {
                self.below_end[piece] - (x - low) * mean_from_low(x)?
            };
            let span = (start - end).powi(2);
            energy
                / (span
                    * (0.5 * (FRAC_PI_2 - phi)).sin().powi(2)
                    * (0.5 * (FRAC_PI_2 + phi)).sin().powi(2))
        };
        Ok((self.weight)(x) / (2.0 * quotient).sqrt())
    }
}

/// Whether a force grows without bound towards zero, on both sides; `size` is the scale of the
/// motion.
pub fn grows_towards_zero(force: &dyn Fn(f64) -> f64, size: f64) -> bool {
    [1.0, -1.0].into_iter().all(|side| {
        let [near, far, farther] =
            [1e-200, 1e-100, 1e-50].map(|part| force(side * part * size).abs());
        far > farther && near > far
    })
}

/// Adds knots on both sides of zero, at distances of equal ratio: on each of these pieces a force
/// that is infinite at zero is smooth.
fn graded(knots: &[f64]) -> Vec<f64> {
    /// Relative distance below which a piece adds less to the period than its rounding.
    const CLOSEST: f64 = 1e-15;
    const RATIO: f64 = 0.25;
    let (end, start) = (knots[0], knots[knots.len() - 1]);
    let sizes = std::iter::successors(Some(RATIO * start), |size| Some(RATIO * size));
    let mut found: Vec<f64> = knots.to_vec();
    found.push(0.0);
    found.extend(
        sizes.take_while(|size| size.abs() > CLOSEST * start.abs()).flat_map(|size| [size, -size]),
    );
    found.sort_by(|one, other| match end < start {
        true => one.total_cmp(other),
        false => other.total_cmp(one),
    });
    // The knots 0 and -0 are one.
    found.dedup_by(|next, last| next == last);
    found
}

/// Adds knots where the force oscillates too often between two of these for [`MOST_PANELS`] panels,
/// until a few panels suffice. Without them every value of `dt/dphi` would need an integral over
/// many waves, at a total cost as the square of their number. A piece that ends at a zero at which
/// the force is infinite is left as it is, and so is one that ends at a power and has a `series` of few
/// terms. Returns
/// the knots and the series of the pieces between them.
///
/// # Errors
/// [`PeriodError::Waves`] if too many knots are needed.
fn resolved(
    force: &PiecewiseForce,
    knots: &[f64],
    infinite_middle: bool,
    series: &dyn Fn(&[f64], usize) -> Option<MeanValues>,
) -> Result<(Vec<f64>, Vec<Option<MeanValues>>), PeriodError> {
    const FEW_PANELS: i32 = 4;
    const MOST_KNOTS: usize = 1 << 14;
    const HALVINGS: u32 = 15;
    /// The most terms of a series next to a power.
    const FEW_TERMS: usize = 128;
    let mut found: Vec<f64> = knots.first().copied().into_iter().collect();
    let mut means: Vec<Option<MeanValues>> = vec![];
    for pair in knots.windows(2) {
        // Next to a power no number of equal panels would do.
        let graded = series(pair, FEW_TERMS).filter(|means| means.power_at().is_some());
        if graded.is_some() {
            found.push(pair[1]);
            means.push(graded);
            continue;
        }
        let in_the_middle = infinite_middle && pair.contains(&0.0);
        if in_the_middle
            || converged_value(force.value, pair[0], pair[1], 0.0, MOST_PANELS).is_some()
        {
            found.push(pair[1]);
            means.push(series(pair, MOST_TERMS));
            continue;
        }
        let mut open = vec![(pair[0], pair[1], 0)];
        while let Some((from, to, halvings)) = open.pop() {
            if found.len() + open.len() > MOST_KNOTS {
                return Err(PeriodError::Waves);
            }
            if halvings == HALVINGS
                || converged_value(force.value, from, to, 0.0, FEW_PANELS).is_some()
            {
                found.push(to);
                means.push(series(&[from, to], MOST_TERMS));
                continue;
            }
            let middle = 0.5 * (from + to);
            open.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]);
        }
    }
    Ok((found, means))
}

/// Panels after which an integral is left to adaptive quadrature.
const MOST_PANELS: i32 = 64;

/// Returns the integral of a force: the number of panels is doubled until the value converges.
/// Absolute errors below `negligible` do not count.
fn integral(
    function: &dyn Fn(f64) -> f64,
    from: f64,
    to: f64,
    negligible: f64,
) -> Result<f64, QuadratureError> {
    const MOST: usize = 1000;
    integral_within(function, [from, to], negligible, MOST)
}

/// Integrates as [`integral`]; adaptive quadrature, if it is needed, uses `most_panels` panels at
/// most.
fn integral_within(
    function: &dyn Fn(f64) -> f64,
    [from, to]: [f64; 2],
    negligible: f64,
    most_panels: usize,
) -> Result<f64, QuadratureError> {
    if let Some(value) = converged_value(function, from, to, negligible, MOST_PANELS) {
        return Ok(value);
    }
    match integrate_within(function, &[from, to], [TOLERANCE, 0.0], most_panels) {
        // If attraction and repulsion cancel, the integral is as accurate as the forces in it
        // allow.
        Err(QuadratureError::NotConverged { value, error_estimate, .. })
            if error_estimate <= f64::max(1e-11 * size(function, from, to), negligible) =>
        {
            Ok(value)
        }
        result => result.map(|(value, _)| value),
    }
}

/// Returns the value to which the integral converges while the number of panels is doubled, or the
/// value from which on doubling brings it no closer, since the force itself is rounded; `None` if
/// it does not converge with `most_panels` panels.
fn converged_value(
    function: &dyn Fn(f64) -> f64,
    from: f64,
    to: f64,
    negligible: f64,
    most_panels: i32,
) -> Option<f64> {
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
        if next <= f64::max(TOLERANCE * finer.abs(), negligible)
            || (next >= 0.5 * change && next <= 1e-9 * finer.abs())
        {
            return Some(finer);
        }
        (value, change) = (finer, next);
        panels *= 2;
    }
    None
}

/// Returns a rough integral of the absolute value of a function.
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
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::period::{PiecewiseForce, turning_point};
///
/// let end = turning_point(&PiecewiseForce::smooth(&|x| x + 0.5 * x * x), 0.0, 0.5)?;
/// let energy = |x: f64| x * x / 2.0 + x.powi(3) / 6.0;
/// assert!(end < -0.5 && (energy(end) - energy(0.5)).abs() < 1e-12);
/// # Ok::<(), lindstedt::numeric::period::PeriodError>(())
/// ```
pub fn turning_point(
    force: &PiecewiseForce,
    equilibrium: f64,
    start: f64,
) -> Result<f64, PeriodError> {
    /// Number of steps per window of the search.
    const STEPS: usize = 64;
    const FARTHEST: f64 = 1e10;
    /// Number of amplitudes beyond which a search that runs out of evaluations counts as an escape,
    /// as over one summit of a pendulum after the other.
    const FAR: f64 = 100.0;
    /// Number of halvings of an interval on which the force has no integral.
    const HALVINGS: u32 = 60;
    /// Number of panels, enough for a square root at an end of a stretch; a stretch with a pole is
    /// halved the sooner.
    const FEW_PANELS: usize = 120;
    /// Largest number of evaluations, about a second; a force of a hundred thousand waves takes
    /// less.
    const MOST_EVALUATIONS: u64 = 20_000_000;
    let evaluations = Cell::new(0_u64);
    let value = |x: f64| {
        evaluations.set(evaluations.get() + 1);
        force.value_at(x)
    };
    let amplitude = start - equilibrium;
    let side = amplitude.signum();
    if force.value_at(start) * side <= 0.0 || amplitude == 0.0 {
        return Err(PeriodError::PushedAway { start, equilibrium, range: None });
    }
    if is_symmetric(force, equilibrium, amplitude) {
        return Ok(equilibrium - amplitude);
    }
    // Errors below the last digit of the largest energy on the way do not count.
    let below = |largest: f64| 0.5 * f64::EPSILON * largest;
    let gained = |from: f64, to: f64, largest: f64| integral(&value, to, from, below(largest));
    // The windows grow: to the mirror image of the start, as far again, twice as far, ...
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
                if evaluations.get() > MOST_EVALUATIONS {
                    return Err(match (here - equilibrium).abs() > FAR * amplitude.abs() {
                        true => PeriodError::Escapes { start, searched: here, range: None },
                        false => PeriodError::Waves,
                    });
                }
                let gain = match integral_within(&value, [next, here], below(largest), FEW_PANELS) {
                    // A pole is approached by half of the way at a time.
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
                    let end =
                        root.map_err(|error| failure.map_or(error.into(), PeriodError::from))?;
                    return match (end - equilibrium) * amplitude > 0.0 {
                        true => Err(PeriodError::OtherWell { start, equilibrium, range: None }),
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
    Err(PeriodError::Escapes { start, searched: x, range: None })
}

/// Whether the well is symmetric and has a single bottom as far as the amplitude. The mirror image
/// of the start is then the turning point to the last digit, which no root finder gives near a
/// separatrix.
fn is_symmetric(force: &PiecewiseForce, equilibrium: f64, amplitude: f64) -> bool {
    /// Relative asymmetry that counts as rounding if the force is infinite in the middle, which the
    /// search for a turning point could not pass.
    const ROUNDING: f64 = 1e-12;
    let infinite = grows_towards_zero(&|y| force.value_at(equilibrium + y), amplitude);
    let rounding = if infinite { ROUNDING } else { 0.0 };
    let mut places: Vec<f64> = (1..=16).map(|k| amplitude * f64::from(k) / 16.0).collect();
    let knots = force.knots(equilibrium - amplitude, equilibrium + amplitude);
    places.extend(knots.iter().map(|knot| knot - equilibrium));
    places.extend(knots.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]) - equilibrium));
    places.into_iter().filter(|&x| x != 0.0).all(|x| {
        let (here, there) = (force.value_at(equilibrium + x), force.value_at(equilibrium - x));
        (here + there).abs() <= rounding * here.abs() && here * x.signum() > 0.0
    })
}

/// Returns a step of the search; cut into parts if the force within it first retards and then
/// drives the motion, so that no minimum of the kinetic energy lies unseen between two ends.
fn where_it_turns(force: &PiecewiseForce, side: f64, from: f64, to: f64) -> Vec<(f64, f64)> {
    const SAMPLES: usize = 4;
    let place = |k: usize| from + (to - from) * k as f64 / SAMPLES as f64;
    let drives: Vec<bool> = (1..SAMPLES).map(|k| force.value_at(place(k)) * side > 0.0).collect();
    if drives.windows(2).all(|pair| pair[0] || !pair[1]) {
        return vec![(from, to)];
    }
    (0..SAMPLES).map(|k| (place(k), if k + 1 == SAMPLES { to } else { place(k + 1) })).collect()
}

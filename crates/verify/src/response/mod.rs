//! Steady states of an oscillator, driven or self-excited: all branches of periodic motions with
//! their stability, and their bifurcations.
//!
//! ```text
//! x'' + f(x, x', t; p) = 0,  f periodic in t:    X(theta) = a_0 + sum a_k cos(k theta) + b_k sin(k theta),  theta = omega t
//! ```
//!
//! In: a [`ResponseRequest`]: an oscillator with numbers for all parameters but one, and the range
//! in which that one varies. Out: a [`ResponseDiagram`]: branches found by harmonic balance and
//! followed by pseudo-arclength; the multipliers of the true motion near each of their points;
//! folds, crossings, period doublings, Neimark-Sacker points; backbones; and the errors against
//! motions found by Runge-Kutta. Units are those of the equation.
//!
//! - [`driven`]: the equation in the phase of the motion.
//! - [`balance`]: its equations for Fourier coefficients.
//! - [`continuation`]: the branches.
//! - [`stability`]: the true motion by shooting, its multipliers; simulations that settle.
//! - `series`: the motion and the map of a period by Taylor series; `shooting`: branches by that map
//!   where the force has corners; `free_swing`: the free motion there.
//! - [`jump`]: motions across dry friction, sticking included; `sticking`: their branches.
//! - [`bifurcation`]: where a branch changes.
//! - [`backbone`]: the free motion without damping.
//! - [`slow`]: the same motions by slow equations of amplitude and phase.
//!
//! - [`cycle`]: the true motion without a drive, by shooting for start and period together;
//!   [`hopf`]: the Hopf point at which it begins.
//!
//! - `seeds`: the motions from which branches start; `one_harmonic` and `melnikov`: guesses of motions
//!   of every size; `narrow`: bifurcations between two points of a branch.
//!
//! Branches start where a simulation settles, from rest and from a ring of starts at several values
//! of the parameter, where a balance or shooting comes to a motion from a guess, at more values, and
//! where others cross. So closed and disconnected branches are found as well. Limit cycles are found
//! by the return map of their turning points, forward and backward in time.

pub mod backbone;
pub mod balance;
pub mod bifurcation;
mod branches;
pub mod continuation;
pub mod cycle;
pub mod driven;
mod error;
mod free_swing;
pub mod hopf;
mod judgement;
pub mod jump;
mod melnikov;
mod narrow;
mod one_harmonic;
mod ripple;
mod seeds;
mod self_excited;
mod series;
mod shooting;
pub mod slow;
pub mod stability;
mod sticking;
mod unfollowed;

use std::cell::Cell;
use std::collections::BTreeMap;

use num_complex::Complex;

use crate::expr::Expr;
use crate::interrupt::{Interrupt, Progress};
use crate::oscillator::Oscillator;
use crate::symbol::Symbol;
use crate::trajectory::by_sides;
use crate::values::Values;
use crate::verify::Verdict;

pub use error::{ResponseError, SeedSearch};
pub use ripple::Ripple;

use backbone::{BackbonePoint, backbones};
use balance::DrivenBalance;
use bifurcation::BifurcationKind;
use branches::largest;
use continuation::{BranchEnd, BranchNode, BranchPath, ContinuationSettings};
use driven::Driven;
use judgement::PointJudgement;
use ripple::LocatedBifurcation;
use seeds::{InitialMotions, Seed, size_of};
use series::PeriodSeries;
use slow::SlowResponse;
use stability::SimulationBudget;

/// A response to be computed: equation, parameter, range and accuracy.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseRequest {
    /// The equation.
    pub oscillator: Oscillator,
    /// Exact values of all parameters but the one that varies.
    pub values: Values,
    /// The parameter that varies.
    pub parameter: Symbol,
    /// Its lowest and its highest value.
    pub range: [f64; 2],
    /// Number of harmonics; if `None`, as many as bring the error below a tenth of the tolerance,
    /// 64 at most.
    pub harmonics: Option<usize>,
    /// Number of drive periods in one period of the motion.
    pub periods: usize,
    /// The largest relative error of a passing verdict.
    pub tolerance: f64,
    /// The interrupt.
    pub interrupt: Interrupt,
    /// The observer of the progress: of the search for initial motions, then of the points that are
    /// judged, each time anew.
    pub progress: Progress,
}

/// A steady state.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyMotion {
    /// The parameter that varies.
    pub parameter: f64,
    /// Coefficients of cos(k theta) and sin(k theta), from k = 0, the mean.
    pub harmonics: Vec<[f64; 2]>,
    /// The frequency of the motion: that of the drive over the number of its periods, or its own.
    pub frequency: f64,
    /// The amplitude of the first harmonic of the motion.
    pub amplitude: f64,
    /// Its phase: amplitude * cos(theta - phase).
    pub phase: f64,
    /// Half of the way from the lowest to the highest point.
    pub peak: f64,
    /// Position and velocity at t = 0: those of the true motion where it was found.
    pub start: [f64; 2],
    /// Whether small disturbances die out, by the multipliers; without damping, whether they do not
    /// grow. `None` if they could not be found.
    pub stable: Option<bool>,
    /// The multipliers, the larger first; of a self-excited motion the one that decides, then the
    /// one along the motion, which is 1.
    pub multipliers: Option<[Complex<f64>; 2]>,
    /// The part of a period in which it sticks, held by dry friction.
    pub stuck: f64,
    /// The error of amplitude or peak against the true motion that shooting found, the larger, over
    /// the true peak, or that of the frequency, over the true one, if that is larger; `None` if
    /// shooting found no motion near.
    pub error: Option<f64>,
}

/// A branch of steady states.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Its points in order.
    pub points: Vec<SteadyMotion>,
    /// The reason why it ends before the first one and behind the last.
    pub ends: [BranchEnd; 2],
    /// Whether its mirror image, -x half a period of the drive later, is a branch as well, which is
    /// not listed.
    pub mirrored: bool,
}

/// A place where a branch changes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "schema",
    derive(schemars::JsonSchema),
    schemars(rename = "ResponseBifurcation")
)]
pub struct Bifurcation {
    /// What happens: the branch turns back, another one crosses, motions of twice the period come
    /// off, a second frequency comes in, a self-excited motion is born from rest, motions of every
    /// amplitude at one value of the parameter.
    #[cfg_attr(feature = "schema", schemars(with = "String", extend("enum" = BifurcationKind::ALL.map(BifurcationKind::name))))]
    pub kind: BifurcationKind,
    /// The branch, counted from 0.
    pub branch: usize,
    /// The value of the parameter that varies.
    pub parameter: f64,
    /// The frequency of the motion.
    pub frequency: f64,
    /// The amplitude of the first harmonic.
    pub amplitude: f64,
    /// Half of peak to peak.
    pub peak: f64,
}

impl Bifurcation {
    /// Whether this is the same bifurcation, met from another branch or from the other half of one.
    fn is_near(&self, other: &Self, [low, high]: [f64; 2], size: f64) -> bool {
        // At a branch point each branch locates the bifurcation with less accuracy.
        let near = if self.kind == BifurcationKind::BranchPoint { 2e-4 } else { 1e-5 };
        self.kind == other.kind
            && (self.parameter - other.parameter).abs() <= near * (high - low)
            && (self.peak - other.peak).abs() <= 1e-2 * size
    }
}

/// A simulation that has settled.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "SimulatedPoint"))]
pub struct Simulated {
    /// The value of the parameter that varies.
    pub parameter: f64,
    /// Its frequency.
    pub frequency: f64,
    /// The amplitude of its first harmonic.
    pub amplitude: f64,
    /// Half of peak to peak.
    pub peak: f64,
    /// The error of the point of the branch against it, over its peak; or that of the frequency, if
    /// it is larger.
    pub error: f64,
}

/// A simulation that has settled elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "ElsewherePoint"))]
pub struct Elsewhere {
    /// The value of the parameter that varies.
    pub parameter: f64,
    /// After how many periods of the motion it repeats itself, 1 where harmonic balance has not
    /// come to it; null where it does not within eight.
    pub periods: Option<usize>,
    /// After how many periods of the drive it repeats itself; null where it does not.
    pub drive_periods: Option<usize>,
    /// Position and velocity at t = 0 or a whole number of periods later, from where it goes on as it
    /// has settled.
    pub start: [f64; 2],
    /// The amplitude of the first harmonic of a period of the motion from there.
    pub amplitude: f64,
    /// Half of the way from the lowest to the highest point of this period.
    pub peak: f64,
}

impl Elsewhere {
    /// Sorts by parameter, number of periods and size, and leaves out what has settled on the same
    /// motion, or does not settle at the same value of the parameter.
    fn sort(all: &mut Vec<Self>) {
        /// Relative difference of the sizes below which two motions are one.
        const SAME: f64 = 1e-3;
        all.sort_by(|one, other| {
            let parameters = one.parameter.total_cmp(&other.parameter);
            let periods = one.drive_periods.cmp(&other.drive_periods);
            parameters.then(periods).then(one.peak.total_cmp(&other.peak))
        });
        all.dedup_by(|one, other| {
            let same_size = (one.peak - other.peak).abs() <= SAME * one.peak.max(other.peak);
            one.parameter == other.parameter
                && one.drive_periods == other.drive_periods
                && (same_size || one.periods.is_none())
        });
    }
}

/// The steady states over the range of the parameter: branches, bifurcations and simulations.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseDiagram {
    /// The request that this answers.
    pub question: ResponseRequest,
    /// The frequency of the drive; without a drive, a name for the frequency of the motion, whose
    /// value each point holds.
    pub frequency: Expr,
    /// Whether there is no drive.
    pub self_excited: bool,
    /// Whether there is no damping.
    pub undamped: bool,
    /// Whether the force jumps with the velocity, as dry friction does, or with the position.
    pub jumps: bool,
    /// Whether all branches are those of the map of a period, because the force has corners, or
    /// jumps that harmonic balance cannot treat.
    pub by_map: bool,
    /// Number of harmonics kept.
    pub harmonics: usize,
    /// The branches, in the order in which they were found.
    pub branches: Vec<Branch>,
    /// Folds and the like, branch by branch.
    pub bifurcations: Vec<Bifurcation>,
    /// Folds of the balance that the true motion does not have, left out of the list.
    pub ripple: Option<Ripple>,
    /// The free motion without damping, about each equilibrium; empty if the frequency does not
    /// vary.
    pub backbone: Vec<Vec<BackbonePoint>>,
    /// Simulations that have settled on stable points.
    pub simulated: Vec<Simulated>,
    /// Simulations that have settled on something else, or on a motion of this period that lies on
    /// no branch.
    pub elsewhere: Vec<Elsewhere>,
    /// The largest error of all points and simulations.
    pub error: Option<f64>,
    /// Points beside which shooting found no true motion.
    pub unjudged: usize,
    /// Whether the error of everything found is within the tolerance and every motion was followed.
    pub verdict: Verdict,
    /// The steady motions by slow equations, if requested.
    pub slow: Option<SlowResponse>,
    /// Whether the computation was completed without an interrupt.
    pub complete: bool,
}

/// The largest number of harmonics.
pub const MOST_HARMONICS: usize = 64;

/// The largest number of drive periods in one period of the motion.
pub const MOST_PERIODS: usize = 12;

/// The longest step along a branch, as a fraction of the range and of the size of the motion.
const LONGEST_STEP: f64 = 0.03;

/// Largest number of points of a branch.
const MOST_POINTS: usize = 1500;

/// Largest number of evaluations of the force in simulations: some seconds of work.
const MOST_EVALUATIONS: usize = 10_000_000;

/// Largest number of branches that are followed.
const MOST_BRANCHES: usize = 32;

/// Computes and verifies all steady states that are found.
///
/// # Errors
/// [`ResponseError`].
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::response::{ResponseRequest, respond};
///
/// // Duffing's equation, hardening: a jump down on the way up.
/// let question = ResponseRequest::new("x'' + x'/10 + x + x^3 - F*cos(Omega*t) = 0", "Omega", [0.5, 2.5], "F = 3/10")?;
/// let response = respond(&question)?;
/// let fold = &response.bifurcations[0];
/// assert_eq!((fold.kind.name(), response.branches.len()), ("fold", 1));
/// assert!((fold.parameter - 1.7797).abs() < 1e-3, "{}", fold.parameter);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn respond(question: &ResponseRequest) -> Result<ResponseDiagram, ResponseError> {
    let asked = PreparedRequest::new(question)?;
    if asked.period_series.is_none() {
        return asked.balanced_response();
    }
    let shot = asked.shot_response();
    // Where nearly all orbits are right a balance would not have smaller errors.
    let is_answer = match &shot {
        Ok(response) => {
            response.verdict == Verdict::Pass || !response.complete || response.has_right_points()
        }
        Err(_) => question.interrupt.is_requested(),
    };
    if is_answer {
        return shot;
    }
    let balanced = PreparedRequest { period_series: None, ..asked }.balanced_response();
    match (&shot, &balanced) {
        (Ok(_), Ok(response)) if response.verdict != Verdict::Pass => shot,
        (Ok(_), Err(_)) => shot,
        _ => balanced,
    }
}

impl ResponseDiagram {
    /// Whether a branch ends for this reason.
    fn ends_with(&self, end: BranchEnd) -> bool {
        self.branches.iter().any(|branch| branch.ends.contains(&end))
    }

    /// Whether all but one in twenty of the points are within the tolerance of a true motion, and no
    /// motion is missed.
    fn has_right_points(&self) -> bool {
        let points = self.branches.iter().flat_map(|branch| &branch.points);
        let is_right = |point: &SteadyMotion| {
            point.error.is_some_and(|error| error <= self.question.tolerance)
        };
        let (all, wrong) = points
            .fold((0, 0), |(all, wrong), point| (all + 1, wrong + usize::from(!is_right(point))));
        20 * wrong <= all && !self.elsewhere.iter().any(|place| place.periods == Some(1))
    }

    /// This response with the largest error of its points and simulations, and the verdict on it.
    fn with_verdict(mut self) -> Self {
        let points = || self.branches.iter().flat_map(|branch| &branch.points);
        let errors = points().filter_map(|point| point.error);
        let errors = errors.chain(self.simulated.iter().map(|simulated| simulated.error));
        let error = errors.fold(None, |largest: Option<f64>, error| {
            Some(largest.map_or(error, |largest| largest.max(error)))
        });
        let (all, unjudged) = points().fold((0, 0), |(all, none), point| {
            (all + 1, none + usize::from(point.error.is_none()))
        });
        let small = error.is_some_and(|error| error <= self.question.tolerance);
        let missed = self.elsewhere.iter().any(|elsewhere| elsewhere.periods == Some(1));
        self.verdict = Verdict::from_passed(small && 20 * unjudged <= all && !missed);
        (self.error, self.unjudged) = (error, unjudged);
        self
    }
}

impl ResponseRequest {
    /// A request with automatic harmonics, a tolerance of 1 %, and motions of the period of the
    /// drive.
    ///
    /// # Errors
    /// A text that is not an equation, or values that cannot be read.
    pub fn new(
        equation: &str,
        parameter: &str,
        range: [f64; 2],
        values: &str,
    ) -> Result<Self, Box<dyn std::error::Error>> {
        Ok(Self {
            oscillator: Oscillator::parse(equation)?,
            values: values.parse()?,
            parameter: Symbol::new(parameter),
            range,
            harmonics: None,
            periods: 1,
            tolerance: 0.01,
            interrupt: Interrupt::default(),
            progress: Progress::default(),
        })
    }
}

/// A request with its equation compiled.
struct PreparedRequest<'a> {
    question: &'a ResponseRequest,
    /// The equation with all values but one.
    oscillator: Oscillator,
    driven: Driven,
    /// The map of a period, if branches are found by shooting.
    period_series: Option<PeriodSeries>,
    /// Progress of the search for initial motions.
    tried: Cell<SeedSearch>,
}

impl<'a> PreparedRequest<'a> {
    fn new(question: &'a ResponseRequest) -> Result<Self, ResponseError> {
        let ResponseRequest { oscillator, parameter, .. } = question;
        let known = &oscillator.parameters;
        let self_excited = !oscillator.force.contains(Symbol::new("t"));
        if self_excited && oscillator.parts().is_ok_and(|parts| parts.damping.is_zero()) {
            return Err(ResponseError::NoDrive);
        }
        if self_excited && question.periods != 1 {
            return Err(ResponseError::NoPeriods(question.periods));
        }
        if !known.contains(parameter) {
            return Err(ResponseError::NoParameter { name: *parameter, known: known.clone() });
        }
        if question.values.get(*parameter).is_some() {
            return Err(ResponseError::Given(*parameter));
        }
        if let Some((unknown, _)) = question.values.iter().find(|(name, _)| !known.contains(name)) {
            return Err(ResponseError::Unknown(unknown));
        }
        let missing = |name: &&Symbol| *name != parameter && question.values.get(**name).is_none();
        let missing: Vec<Symbol> = known.iter().filter(missing).copied().collect();
        if !missing.is_empty() {
            return Err(ResponseError::Missing(missing));
        }
        let [low, high] = question.range;
        if !(low < high && (high - low).is_finite()) {
            return Err(ResponseError::Range(*parameter));
        }
        for (what, given, most) in [
            ("the number of harmonics", question.harmonics.unwrap_or(1), MOST_HARMONICS),
            ("the number of periods", question.periods, MOST_PERIODS),
        ] {
            if !(1..=most).contains(&given) {
                return Err(ResponseError::Count { what, given, most });
            }
        }
        let values: BTreeMap<Symbol, Expr> = question.values.split(known).0;
        let oscillator = oscillator.with_values(&values)?;
        let force = by_sides(&oscillator.force, oscillator.coordinate, &BTreeMap::new())?;
        let oscillator = Oscillator { force, ..oscillator };
        let driven = Driven::new(&oscillator, *parameter, question.periods)?;
        if driven.self_excited && driven.undamped {
            return Err(ResponseError::NoDrive);
        }
        // A number of harmonics is a wish for a balance of so many.
        let shot = question.harmonics.is_none()
            && !driven.smooth
            && driven.jumps() == 0
            && !driven.self_excited
            && !driven.undamped;
        let period_series = shot.then(|| PeriodSeries::new(&driven)).flatten();
        let asked = Self { question, oscillator, driven, period_series, tried: Cell::default() };
        asked.has_frequency()
    }

    /// The response by shooting: harmonics are only output.
    fn shot_response(&self) -> Result<ResponseDiagram, ResponseError> {
        let InitialMotions { seeds, elsewhere, branches } = self.seeds(MOST_HARMONICS)?;
        let mut response = self.attempt(MOST_HARMONICS, &seeds, &branches)?;
        response.elsewhere.extend(elsewhere);
        Elsewhere::sort(&mut response.elsewhere);
        Ok(response)
    }

    /// The response by harmonic balance, with as many harmonics as it takes, or by the map of a
    /// period from jump to jump.
    fn balanced_response(&self) -> Result<ResponseDiagram, ResponseError> {
        const FIRST: usize = 8;
        // For the map of a period harmonics are only output, so that the largest number costs nothing.
        let automatic = match self.driven.is_balanced() {
            true => FIRST,
            false => MOST_HARMONICS,
        };
        let first = self.question.harmonics.unwrap_or(automatic);
        let InitialMotions { seeds, elsewhere, branches } = self.seeds(first)?;
        let mut harmonics = first;
        let mut before = (f64::INFINITY, usize::MAX);
        let mut fewer: Option<ResponseDiagram> = None;
        loop {
            // The search has followed branches with the first number of harmonics.
            let known = if harmonics == first { &branches[..] } else { &[] };
            let attempt = self.attempt(harmonics, &seeds, known);
            let may_have_more =
                self.question.harmonics.is_none() && 2 * harmonics <= MOST_HARMONICS;
            if matches!(attempt, Err(ResponseError::NotFollowed { .. }))
                && may_have_more
                && fewer.is_none()
            {
                harmonics *= 2;
                continue;
            }
            // If the computation is interrupted on the way to more harmonics, the result with fewer of
            // them is the answer.
            let mut response = match (attempt, fewer.take()) {
                (Ok(response), None) => response,
                (Ok(response), Some(_)) if response.complete => response,
                (_, Some(response)) => ResponseDiagram { complete: false, ..response },
                (Err(error), None) => return Err(error),
            };
            let points: usize = response.branches.iter().map(|branch| branch.points.len()).sum();
            let judged = 100 * response.unjudged <= points;
            let resolved = !response.ends_with(BranchEnd::Harmonics);
            let followed = response.elsewhere.is_empty();
            let good = resolved
                && judged
                && followed
                && response.error.is_some_and(|error| error <= 0.1 * self.question.tolerance);
            // An error that more harmonics do not reduce has another cause, such as a jump of the
            // force.
            let now = (response.error.unwrap_or(f64::INFINITY), response.unjudged);
            let stalled = resolved && followed && now.0 >= 0.7 * before.0 && now.1 >= before.1;
            // Without a branch there is no error either.
            before = if followed { now } else { (f64::INFINITY, usize::MAX) };
            let fixed = self.question.harmonics.is_some() || !response.complete;
            let last = fixed || good || stalled || 2 * harmonics > MOST_HARMONICS;
            if last {
                response.elsewhere.extend(elsewhere);
                Elsewhere::sort(&mut response.elsewhere);
                return match response.self_excited {
                    true => self.without_tails(response),
                    false => Ok(response),
                };
            }
            harmonics *= 2;
            fewer = Some(response);
        }
    }

    /// Checks that the frequency of the drive is positive in all of the range.
    fn has_frequency(self) -> Result<Self, ResponseError> {
        let (parameter, [low, high]) = (self.question.parameter, self.question.range);
        for part in 0..=20 {
            let at = low + (high - low) * f64::from(part) / 20.0;
            let value = self.driven.frequency_at(at);
            if !(value > 0.0 && value.is_finite()) {
                return Err(ResponseError::Frequency {
                    frequency: self.driven.frequency.to_string(),
                    value: value * self.question.periods as f64,
                    parameter,
                    at,
                });
            }
        }
        Ok(self)
    }

    /// The evaluations that the simulations of one purpose may take together.
    fn budget(&self) -> SimulationBudget {
        SimulationBudget { evaluations: MOST_EVALUATIONS, interrupt: self.question.interrupt }
    }

    fn walk(&self, seeds: &[Seed], size: f64) -> ContinuationSettings {
        ContinuationSettings {
            // Motions with corners and slow motions have long series of harmonics, and other
            // criteria for their ends.
            resolved: self.question.harmonics.is_none()
                && self.driven.smooth
                && !self.driven.self_excited,
            ordinary: size_of(seeds),
            range: self.question.range,
            longest: LONGEST_STEP,
            most: MOST_POINTS,
            size,
            interrupt: self.question.interrupt,
        }
    }

    /// The whole diagram with this many harmonics; some of its branches may be known already.
    fn attempt(
        &self,
        harmonics: usize,
        seeds: &[Seed],
        known: &[BranchPath],
    ) -> Result<ResponseDiagram, ResponseError> {
        let question = self.question;
        let balance = DrivenBalance::new(&self.driven, harmonics);
        let mut paths = self.branches_through(&balance, seeds, size_of(seeds), known);
        let largest_motion = paths.iter().map(|path| largest(&balance, path));
        let size = largest_motion.fold(size_of(seeds), f64::max);
        self.follow_sticking(&balance, seeds, &mut paths, size);
        let (all_judged, changes, ripple) = self.judged_paths(&balance, seeds, &mut paths);
        // Sizes are compared with the largest motion of all branches.
        let size = paths.iter().map(|path| largest(&balance, path)).fold(0.0, f64::max);
        let bifurcations = self.bifurcations(&balance, changes, size);
        let branches: Vec<Branch> = paths
            .iter()
            .zip(all_judged)
            .map(|(path, judged)| {
                let points = path.nodes.iter().zip(judged);
                Branch {
                    points: points
                        .map(|(node, judged)| self.point(&balance, node, judged, size))
                        .collect(),
                    ends: path.ends,
                    mirrored: path.mirrored,
                }
            })
            .collect();
        if branches.is_empty() {
            return Err(match question.interrupt.is_requested() || self.driven.undamped {
                true => self.no_motion_error(),
                false => ResponseError::NotFollowed {
                    parameter: question.parameter,
                    range: question.range,
                },
            });
        }
        let simulated = self.simulated(&branches);
        let elsewhere = self.unfollowed(&balance, &paths, seeds, size);
        let points = || branches.iter().flat_map(|branch| &branch.points);
        let complete = !question.interrupt.is_requested();
        let amplitude = points().map(|point| point.amplitude).fold(0.0, f64::max);
        let response = ResponseDiagram {
            question: question.clone(),
            frequency: self.driven.frequency.clone(),
            self_excited: self.driven.self_excited,
            undamped: self.driven.undamped,
            jumps: self.driven.jumps() > 0,
            by_map: !self.driven.is_balanced() || self.period_series.is_some(),
            harmonics: balance.core.harmonics,
            backbone: backbones(
                &self.oscillator,
                &self.driven,
                (harmonics, self.period_series.is_some()),
                question.range,
                1.15 * amplitude,
            )?,
            branches,
            bifurcations,
            ripple,
            simulated,
            elsewhere,
            verdict: Verdict::Fail,
            error: None,
            unjudged: 0,
            slow: None,
            complete,
        };
        Ok(response.with_verdict())
    }

    /// This response without the ends of branches at which no true motion was found, because the
    /// period grows without bound or there are too few harmonics.
    fn without_tails(
        &self,
        mut response: ResponseDiagram,
    ) -> Result<ResponseDiagram, ResponseError> {
        /// Largest number of consecutive points without a true motion that counts as accidental.
        const FEW: usize = 3;
        let tolerance = response.question.tolerance;
        let mut slowest: Vec<f64> = Vec::new();
        for branch in &mut response.branches {
            let points = &mut branch.points;
            let count = points.len();
            let judged = (0..count).filter(|index| points[*index].error.is_some());
            let judged: Vec<usize> = judged.collect();
            let together = judged.chunk_by(|one, next| next - one <= FEW + 1);
            let longest = together.max_by_key(|part| part.len()).unwrap_or_default();
            let (Some(&(mut first)), Some(&(mut last))) = (longest.first(), longest.last()) else {
                points.clear();
                slowest.push(f64::INFINITY);
                continue;
            };
            // The error grows before the true motion is lost, so that the end is put where it was
            // within tolerance.
            let within =
                |index: &&usize| points[**index].error.is_some_and(|error| error <= tolerance);
            if count - 1 - last > FEW {
                last = longest.iter().rfind(within).copied().unwrap_or(last);
            }
            if first > FEW {
                first = longest.iter().find(within).copied().unwrap_or(first);
            }
            if count - 1 - last > FEW {
                points.truncate(last + 1);
                branch.ends[1] = BranchEnd::Slow;
            }
            if first > FEW {
                points.drain(..first);
                branch.ends[0] = BranchEnd::Slow;
            }
            let frequencies = points.iter().map(|point| point.frequency);
            slowest.push(frequencies.fold(f64::INFINITY, f64::min));
        }
        // Bifurcations beyond the new end of a branch are not reliable.
        let slowest_of = |branch: usize| slowest.get(branch).copied().unwrap_or(f64::INFINITY);
        let bifurcations = response.bifurcations.iter();
        let kept = bifurcations.filter(|found| found.frequency >= slowest_of(found.branch));
        let number =
            |branch: usize| (0..branch).filter(|index| slowest_of(*index).is_finite()).count();
        response.bifurcations =
            kept.map(|found| Bifurcation { branch: number(found.branch), ..*found }).collect();
        response.branches.retain(|branch| !branch.points.is_empty());
        match response.branches.is_empty() {
            true => Err(self.no_motion_error()),
            false => Ok(response.with_verdict()),
        }
    }

    /// Verifies every point of the branches and locates the bifurcations between them; branches
    /// that cross are followed and added.
    fn judged_paths(
        &self,
        balance: &DrivenBalance,
        seeds: &[Seed],
        paths: &mut Vec<BranchPath>,
    ) -> (Vec<Vec<PointJudgement>>, Vec<Change>, Option<Ripple>) {
        let size = paths.iter().map(|path| largest(balance, path));
        let walk = self.walk(seeds, size.fold(size_of(seeds), f64::max));
        // Multipliers have a meaning only for a true motion.
        let of_true_motion = |judged: PointJudgement| judged.1.map(|truth| truth.floquet);
        let floquet = |node: &BranchNode| match node.truth {
            Some(truth) => Some(truth.floquet),
            None => of_true_motion(self.judged(balance, node)),
        };
        let mut all_judged: Vec<Vec<PointJudgement>> = Vec::new();
        let mut changes = Vec::new();
        let mut ripple = None;
        while let Some(path) = paths.get(all_judged.len()).cloned() {
            let branch = all_judged.len();
            let points: usize = paths.iter().map(|path| path.nodes.len()).sum();
            let before: usize = all_judged.iter().map(Vec::len).sum();
            self.question.progress.begin(points - before);
            let judged = self.judged_in_time(balance, &path.nodes);
            let between_two =
                |from: &BranchNode, to: &BranchNode, part: f64| match from.truth.or(to.truth) {
                    Some(_) if self.period_series.is_some() => {
                        self.shot_between(balance, from, to, part)
                    }
                    Some(_) => self.stuck_between(balance, from, to, part),
                    None => walk.between(balance, from, to, part),
                };
            let points = path.nodes.into_iter().zip(judged).collect();
            let points = self.add_narrow(balance, points, &between_two);
            let (nodes, judged): (Vec<BranchNode>, Vec<PointJudgement>) =
                points.into_iter().unzip();
            paths[branch].nodes.clone_from(&nodes);
            let mut own: Vec<LocatedBifurcation> = Vec::new();
            for (index, (pair, known)) in nodes.windows(2).zip(judged.windows(2)).enumerate() {
                let ([from, to], [before, after]) = (pair, known) else {
                    continue;
                };
                if self.question.interrupt.is_requested() {
                    break;
                }
                let between = |part: f64| between_two(from, to, part);
                let known = [(from, of_true_motion(*before)), (to, of_true_motion(*after))];
                let found = bifurcation::between(balance, known, &between, &floquet);
                for (mut kind, node) in found {
                    let crossed =
                        kind == BifurcationKind::BranchPoint && paths.len() < MOST_BRANCHES;
                    if crossed && self.follow_crossing(balance, &walk, &node, paths) {
                        kind = BifurcationKind::Centre;
                    }
                    own.push((index, kind, node));
                }
            }
            let (own, left_out) = ripple::without_ripple(own, &nodes, &judged);
            ripple = Ripple::merged_with(ripple, &left_out);
            changes.extend(own.into_iter().map(|(_, kind, node)| (kind, branch, node)));
            let ends = path.ends.iter().zip([nodes.first(), nodes.last()]);
            let born = ends.filter(|(end, _)| **end == BranchEnd::Rest);
            changes.extend(
                born.filter_map(|(_, node)| Some((BifurcationKind::Hopf, branch, node?.clone()))),
            );
            all_judged.push(judged);
        }
        (all_judged, changes, ripple)
    }

    /// The bifurcations of the branches, each once.
    fn bifurcations(
        &self,
        balance: &DrivenBalance,
        changes: Vec<Change>,
        size: f64,
    ) -> Vec<Bifurcation> {
        let mut found: Vec<Bifurcation> = Vec::new();
        for (kind, branch, node) in changes {
            let point = self.point(balance, &node, (None, None), size);
            let new = Bifurcation {
                kind,
                branch,
                parameter: point.parameter,
                frequency: point.frequency,
                amplitude: point.amplitude,
                peak: point.peak,
            };
            if !found.iter().any(|known| new.is_near(known, self.question.range, size)) {
                found.push(new);
            }
        }
        found
    }

    /// Updates the progress of the search for initial motions.
    fn count(&self, [values, starts]: [usize; 2], motions: usize) {
        let before = self.tried.get();
        self.tried.set(SeedSearch {
            values: before.values + values,
            starts: before.starts + starts,
            motions,
        });
    }

    /// The error of a search without a motion.
    fn no_motion_error(&self) -> ResponseError {
        let ResponseRequest { parameter, range, .. } = *self.question;
        match (self.question.interrupt.is_requested(), self.driven.self_excited) {
            (true, _) => ResponseError::Interrupted { parameter, tried: self.tried.get() },
            (false, true) => ResponseError::NoCycle { parameter, range },
            (false, false) => {
                ResponseError::NoMotion { parameter, at: range[0], undamped: self.driven.undamped }
            }
        }
    }
}

/// A bifurcation of a branch, which is counted from 0.
type Change = (BifurcationKind, usize, BranchNode);

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
//!   `multiple_shooting`: a true motion whose disturbances grow too much for a single shot.
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
//! - [`coupled`]: coupled equations of any number of coordinates, by shooting.
//! - `aperiodic`: how motions go on that do not repeat themselves.
//! - `coverage`: the distances between the values at which a search begins.
//! - `seeds`: the motions from which branches start; `one_harmonic` and `melnikov`: guesses of motions
//!   of every size; `narrow`: bifurcations between two points of a branch.
//!
//! Branches start where a simulation settles, from rest and from starts all around at several values
//! of the parameter, where a balance or shooting comes to a motion from a guess, at more values, and
//! where others cross. So closed and disconnected branches are found as well. Limit cycles are found
//! by the return map of their turning points, forward and backward in time.

mod aperiodic;
mod attractors;
pub mod backbone;
pub mod balance;
pub mod bifurcation;
mod branches;
pub mod continuation;
pub mod coupled;
mod coverage;
pub mod cycle;
pub mod driven;
mod equations;
mod error;
mod free_swing;
pub mod hopf;
mod judgement;
pub mod jump;
mod melnikov;
mod multiple_shooting;
mod narrow;
mod one_harmonic;
mod prepared;
mod ripple;
mod seeds;
mod self_excited;
mod series;
mod shooting;
pub mod slow;
pub mod stability;
mod sticking;
mod unfollowed;

use std::collections::BTreeSet;

use num_complex::Complex;

use crate::coupled::CoupledEquations;
use crate::event::StateEvent;
use crate::exact::rational::from_f64;
use crate::expr::Expr;
use crate::interrupt::{Interrupt, Progress};
use crate::oscillator::Oscillator;
use crate::symbol::Symbol;
use crate::values::Values;
use crate::verify::Verdict;
use crate::wall::Wall;

pub use aperiodic::{
    AperiodicMotion, ChaoticMotion, QuasiPeriodicMotion, RotatingMotion, UnsettledMotion,
};
pub use equations::{Equations, EquationsError};
pub use error::{ResponseError, SeedSearch};
pub use ripple::Ripple;

use backbone::BackbonePoint;
use bifurcation::BifurcationKind;
use continuation::BranchEnd;
use prepared::PreparedRequest;
use slow::SlowResponse;

/// A response to be computed: equation, parameter, range and accuracy.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseRequest {
    /// The equations.
    pub equations: Equations,
    /// The quantity that is listed and drawn, in the coordinates of coupled equations; the first of
    /// them without it.
    pub of: Option<Expr>,
    /// Rigid walls, of coupled equations, of which one coordinate may be an example.
    pub walls: Vec<Wall>,
    /// Other events at which states jump.
    pub events: Vec<StateEvent>,
    /// Exact values of all parameters but the one that varies.
    pub values: Values,
    /// The parameter that varies.
    pub parameter: Symbol,
    /// Its lowest and its highest value.
    pub range: [f64; 2],
    /// A second parameter with its range, along which bifurcations are followed; the branches are
    /// those at the value that it has among the values.
    pub along: Option<(Symbol, [f64; 2])>,
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
    /// The part of a period in which it sticks, held by dry friction, or rests on a wall.
    pub stuck: f64,
    /// The number of impacts on walls in a period, without those that accumulate before a rest.
    pub impacts: usize,
    /// The number of other events in a period.
    pub events: usize,
    /// The error of amplitude or peak against the true motion that shooting found, the larger, over
    /// the true peak, or that of the frequency, over the true one, if that is larger; `None` if
    /// shooting found no motion near.
    pub error: Option<f64>,
    /// The motion of each coordinate of coupled equations; empty for a single coordinate, which is
    /// what the other fields describe. Of coupled equations they describe the quantity that is
    /// listed, and the error is that of all coordinates.
    pub coordinates: Vec<CoordinateMotion>,
    /// The energy of a free motion without damping over that of rest, of coupled equations whose
    /// energy is known; else `None`.
    pub energy: Option<f64>,
    /// The value after a period of each state that only counts and begins the period at zero, in the order of
    /// [`ResponseDiagram::counters`]; empty without such states, or where the period could not be followed.
    pub counted: Vec<f64>,
}

/// The motion of one of several coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct CoordinateMotion {
    /// The coordinate.
    pub coordinate: Symbol,
    /// Its position at t = 0.
    pub start: f64,
    /// Its velocity there, or its rate in an equation of first order.
    pub rate: f64,
    /// The amplitude of its first harmonic.
    pub amplitude: f64,
    /// The phase of that: amplitude * cos(theta - phase).
    pub phase: f64,
    /// Half of the way from the lowest to the highest point.
    pub peak: f64,
    /// Coefficients of cos(k theta) and sin(k theta), from k = 0, the mean.
    pub harmonics: Vec<[f64; 2]>,
}

/// An equilibrium of coupled equations that nothing drives.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Equilibrium {
    /// The value of the parameter that varies.
    pub parameter: f64,
    /// The quantity that is listed.
    pub value: f64,
    /// All coordinates, then the velocities of those of second order.
    pub state: Vec<f64>,
    /// The largest real part of an eigenvalue of the linear equations; null where there is none.
    pub growth: Option<f64>,
    /// Whether small disturbances die out; without damping, whether they do not grow.
    pub stable: Option<bool>,
    /// The way to the zero of the equations as they were given, by one step of Newton's method, over the
    /// size of the largest equilibrium; null where the linear equations are singular.
    pub error: Option<f64>,
}

/// A place where a branch of equilibria changes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EquilibriumChange {
    /// The kind of the change: a fold, a branch point, or a Hopf point, where cycles are born.
    #[cfg_attr(feature = "schema", schemars(with = "String", extend("enum" = BifurcationKind::ALL.map(BifurcationKind::name))))]
    pub kind: BifurcationKind,
    /// The value of the parameter that varies.
    pub parameter: f64,
    /// The quantity that is listed.
    pub value: f64,
    /// Whether the cycles that come off at a Hopf point are stable, where that is known.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub criticality: Option<Criticality>,
}

/// A branch of equilibria in order, with its changes.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EquilibriumBranch {
    /// Its points.
    pub points: Vec<Equilibrium>,
    /// Its folds, branch points and Hopf points.
    pub changes: Vec<EquilibriumChange>,
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
    /// Whether the motions that come off are stable, where that is known.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub criticality: Option<Criticality>,
}

/// The side on which motions come off at a bifurcation, and so whether they are stable beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Criticality {
    /// They are unstable, and exist where the motion from which they come is stable: beyond it a
    /// motion jumps.
    Subcritical,
    /// They take over the stability of the motion from which they come.
    Supercritical,
    /// The multipliers of a Neimark-Sacker point are roots of one, of an order up to four: motions of
    /// that many periods come near, and the cubic terms alone do not decide.
    StronglyResonant,
}

/// A curve of bifurcations in two parameters.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BifurcationCurve {
    /// The kind of its bifurcations: fold, period doubling or Neimark-Sacker.
    #[cfg_attr(feature = "schema", schemars(with = "String", extend("enum" = BifurcationKind::ALL.map(BifurcationKind::name))))]
    pub kind: BifurcationKind,
    /// Its points in order.
    pub points: Vec<BifurcationCurvePoint>,
}

/// A bifurcation at values of two parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BifurcationCurvePoint {
    /// The value of the parameter that varies.
    pub parameter: f64,
    /// The value of the second parameter.
    pub along: f64,
    /// Half of peak to peak of the motion there.
    pub peak: f64,
}

/// Numbers of stable motions at values of two parameters.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StableMotions {
    /// The values of the parameter that varies.
    pub parameters: Vec<f64>,
    /// The values of the second parameter.
    pub along: Vec<f64>,
    /// For each value of the second parameter the number of stable motions that were found at each
    /// value of the first.
    pub counts: Vec<Vec<usize>>,
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
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "ElsewherePoint"))]
pub struct Elsewhere {
    /// The value of the parameter that varies.
    pub parameter: f64,
    /// After how many periods of the motion it repeats itself, 1 where harmonic balance has not
    /// come to it; null where it does not.
    pub periods: Option<usize>,
    /// After how many periods of the drive it repeats itself; null where it does not.
    pub drive_periods: Option<usize>,
    /// Position and velocity at t = 0 or a whole number of periods later, from where it goes on as it
    /// has settled.
    pub start: [f64; 2],
    /// All states there, of coupled equations: coordinates, then velocities. Left out for one
    /// coordinate.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub state: Vec<f64>,
    /// The amplitude of the first harmonic of a period of the motion from there.
    pub amplitude: f64,
    /// Half of the way from the lowest to the highest point of this period.
    pub peak: f64,
    /// How it goes on where it does not repeat itself; left out where it does, and where it cannot be followed.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub aperiodic: Option<AperiodicMotion>,
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
    /// The equilibria of coupled equations that nothing drives; else empty.
    pub equilibria: Vec<EquilibriumBranch>,
    /// The curves of bifurcations in two parameters, where a second one was given.
    pub curves: Vec<BifurcationCurve>,
    /// The numbers of stable motions over both, where a second one was given.
    pub stable_motions: Option<StableMotions>,
    /// The states that only count: their rates are zero, and they enter neither forces nor conditions nor other
    /// states. They do not belong to the motions.
    pub counters: Vec<Symbol>,
    /// The states that change at events alone, among finitely many values, with these values.
    pub modes: Vec<(Symbol, Vec<f64>)>,
    /// Whether the search for coupled motions ended because it had taken as much work as it may, so that
    /// branches may be missing or end early, and bifurcations are not listed.
    pub exhausted: bool,
    /// The stretches in which the values at which the search for motions began are so far apart that the
    /// motions of a single coordinate gain more than a swing in a period of the drive from one to the
    /// next. Those that lie outside the range of the question are left out, though they were asked for;
    /// in others branches may be missing.
    pub sparse: Vec<[f64; 2]>,
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

/// Largest number of impacts or other events in a period of the drive for a motion beyond whose grazing others are
/// looked for: where impacts nearly accumulate there are infinitely many grazings on a short stretch.
pub const MOST_IMPACTS: usize = 8;

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
    let question = &question.with_second_value()?;
    match &question.equations {
        Equations::Coupled(equations) => coupled::respond(question, equations),
        // Across impacts and events one coordinate is followed as several are.
        Equations::One(_) if question.has_jumps_of_states() => {
            let equations = CoupledEquations::new(question.equations.sides())
                .map_err(|error| ResponseError::Rates(error.to_string()))?;
            coupled::respond(question, &equations)
        }
        Equations::One(oscillator) if PreparedRequest::has_steps_in_place(question, oscillator) => {
            match respond_across_steps(question, oscillator) {
                Ok(response) => Ok(response),
                Err(_) => respond_in_plane(question, oscillator),
            }
        }
        Equations::One(oscillator) => {
            let (covered, left_out) = covered_part(question, oscillator)?;
            Ok(respond_in_plane(&covered, oscillator)?.with_sparse(left_out))
        }
    }
}

/// The response of a single coordinate whose force steps where it comes to places, as that of a spring with a
/// dashpot: followed as several coordinates are, from step to step with the variations.
fn respond_across_steps(
    question: &ResponseRequest,
    oscillator: &Oscillator,
) -> Result<ResponseDiagram, ResponseError> {
    let equations = CoupledEquations::new(question.equations.sides())
        .map_err(|error| ResponseError::Rates(error.to_string()))?;
    let response = coupled::respond(question, &equations)?;
    let points = response.branches.iter().flat_map(|branch| &branch.points);
    let amplitude = points.map(|point| point.amplitude).fold(0.0, f64::max);
    let backbone = PreparedRequest::new(question, oscillator)?.backbones(amplitude)?;
    Ok(ResponseDiagram { backbone, ..response })
}

/// A request for the part of the range that a search covers, with the parts that are left out: there the
/// motion gains many swings from one start of the search to the next.
fn covered_part(
    question: &ResponseRequest,
    oscillator: &Oscillator,
) -> Result<(ResponseRequest, Vec<[f64; 2]>), ResponseError> {
    let [low, high] = question.range;
    let coverage = PreparedRequest::new(question, oscillator)?.coverage_of_search();
    let Some([from, to]) = coverage.covered(question.range) else {
        return Ok((question.clone(), vec![]));
    };
    let left_out = [[low, from], [to, high]].into_iter().filter(|[low, high]| low < high);
    Ok((ResponseRequest { range: [from, to], ..question.clone() }, left_out.collect()))
}

/// The response of a single coordinate, with what follows from its branches.
fn respond_in_plane(
    question: &ResponseRequest,
    oscillator: &Oscillator,
) -> Result<ResponseDiagram, ResponseError> {
    let mut response = match respond_one(question, oscillator) {
        Err(error @ ResponseError::NotFollowed { .. }) => {
            return followed_from_jump_to_jump(question).unwrap_or(Err(error));
        }
        found => found?,
    };
    response.set_hopf_criticality();
    if response.bifurcations.is_empty() && question.along.is_none() {
        return Ok(response);
    }
    let equations = CoupledEquations::new(question.equations.sides())
        .map_err(|error| ResponseError::Rates(error.to_string()));
    match question.along {
        None => Ok(match equations {
            Ok(equations) => coupled::with_criticality(response, question, &equations),
            Err(_) => response,
        }),
        Some(_) => {
            let equations = equations?;
            let response = coupled::with_criticality(response, question, &equations);
            coupled::with_curves(response, question, &equations)
        }
    }
}

/// The response of a single coordinate as of several, where its motions could not be followed
/// otherwise: `None` if that does not help either.
fn followed_from_jump_to_jump(
    question: &ResponseRequest,
) -> Option<Result<ResponseDiagram, ResponseError>> {
    let equations = CoupledEquations::new(question.equations.sides()).ok()?;
    match coupled::respond(question, &equations) {
        Ok(response) => Some(Ok(response)),
        Err(error @ ResponseError::NothingMoves { .. }) => Some(Err(error)),
        Err(_) => None,
    }
}

/// The response of a single coordinate.
fn respond_one(
    question: &ResponseRequest,
    oscillator: &Oscillator,
) -> Result<ResponseDiagram, ResponseError> {
    let asked = PreparedRequest::new(question, oscillator)?;
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
    /// Sets the criticality of the Hopf points of a single coordinate: in a plane the smallest cycles
    /// are stable where the equilibrium inside them is not.
    fn set_hopf_criticality(&mut self) {
        for change in &mut self.bifurcations {
            let branch =
                self.branches.get(change.branch).filter(|branch| !branch.points.is_empty());
            let Some(branch) = branch.filter(|_| change.kind == BifurcationKind::Hopf) else {
                continue;
            };
            let points = &branch.points;
            let apart = |point: &SteadyMotion| (point.parameter - change.parameter).abs();
            let begins_here = apart(&points[0]) < apart(&points[points.len() - 1]);
            let from_here = |index: usize| match begins_here {
                true => &points[index],
                false => &points[points.len() - 1 - index],
            };
            let moving = (0..points.len()).map(from_here).find(|point| apart(point) > 0.0);
            change.criticality = moving.and_then(|point| point.stable).map(|stable| match stable {
                true => Criticality::Supercritical,
                false => Criticality::Subcritical,
            });
        }
    }

    /// The coordinates that belong to the motions: all but those that only count.
    pub fn coordinates(&self) -> Vec<Symbol> {
        let all = self.question.equations.coordinates();
        all.into_iter().filter(|name| !self.counters.contains(name)).collect()
    }

    /// Whether there are events that set a state which belongs to the motions.
    pub fn has_events(&self) -> bool {
        let assignments = self.question.events.iter().flat_map(|event| &event.assignments);
        { assignments }.any(|(state, _)| !self.counters.contains(state))
    }

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

    /// Whether there are as many branches as are followed, or the search was exhausted, so that more of
    /// them may be missing.
    pub fn is_full(&self) -> bool {
        self.exhausted || self.branches.len() >= MOST_BRANCHES
    }

    /// This response with stretches in which its search was sparse, or that it leaves out.
    fn with_sparse(mut self, sparse: Vec<[f64; 2]>) -> Self {
        if !sparse.is_empty() {
            self.verdict = Verdict::Fail;
            self.sparse.extend(sparse);
            self.sparse.sort_by(|one, other| one[0].total_cmp(&other[0]));
        }
        self
    }

    /// This response with the largest error of its points and simulations, and the verdict on it.
    fn with_verdict(mut self) -> Self {
        let points = || self.branches.iter().flat_map(|branch| &branch.points);
        let errors = points().filter_map(|point| point.error);
        let errors = errors.chain(self.simulated.iter().map(|simulated| simulated.error));
        let equilibria = self.equilibria.iter().flat_map(|branch| &branch.points);
        let errors = errors.chain(equilibria.filter_map(|point| point.error));
        let error = errors.fold(None, |largest: Option<f64>, error| {
            Some(largest.map_or(error, |largest| largest.max(error)))
        });
        let (all, unjudged) = points().fold((0, 0), |(all, none), point| {
            (all + 1, none + usize::from(point.error.is_none()))
        });
        let small = error.is_some_and(|error| error <= self.question.tolerance);
        let missed = self.elsewhere.iter().any(|elsewhere| elsewhere.periods == Some(1));
        let missed = missed || self.is_full() || !self.sparse.is_empty();
        self.verdict = Verdict::from_passed(small && 20 * unjudged <= all && !missed);
        (self.error, self.unjudged) = (error, unjudged);
        self
    }
}

impl ResponseRequest {
    /// This request with another value of a parameter.
    fn at(&self, name: Symbol, value: f64) -> Self {
        let mut values = self.values.split(&[name]).1;
        if let Some(exact) = from_f64(value) {
            // A number that is finite and not there yet is a value.
            let _ = values.insert(name, Expr::number(exact));
        }
        Self { values, ..self.clone() }
    }

    /// Whether states jump, at walls or other events.
    pub fn has_jumps_of_states(&self) -> bool {
        !self.walls.is_empty() || !self.events.is_empty()
    }

    /// The expressions of the walls and the events.
    fn of_jumps(&self) -> impl Iterator<Item = &Expr> {
        let of_walls = self.walls.iter().flat_map(|wall| [&wall.gap, &wall.restitution]);
        of_walls.chain(self.events.iter().flat_map(StateEvent::expressions))
    }

    /// The names of the equations, the walls and the events that need values, in alphabetical order.
    pub fn parameters(&self) -> Vec<Symbol> {
        let coordinates = self.equations.coordinates();
        let is_own = |name: &Symbol| coordinates.contains(&name.coordinate()) || name.name() == "t";
        let of_jumps = self.of_jumps().flat_map(Expr::symbols).filter(|name| !is_own(name));
        let all: BTreeSet<Symbol> =
            self.equations.parameters().iter().copied().chain(of_jumps).collect();
        all.into_iter().collect()
    }

    /// This request with the middle of its range as the value of the second parameter, if that has
    /// none.
    ///
    /// # Errors
    /// A second parameter that is none of the equations or the first one, or a range out of order.
    fn with_second_value(&self) -> Result<Self, ResponseError> {
        let Some((name, [low, high])) = self.along else { return Ok(self.clone()) };
        let known = self.parameters();
        if !known.contains(&name) || name == self.parameter {
            let known = known.iter().copied().filter(|known| *known != self.parameter);
            return Err(ResponseError::NoParameter { name, known: known.collect() });
        }
        if !(low < high && (high - low).is_finite()) {
            return Err(ResponseError::Range(name));
        }
        Ok(match self.values.get(name) {
            Some(_) => self.clone(),
            None => self.at(name, 0.5 * (low + high)),
        })
    }

    /// Checks parameter, values, range and counts, where these are the parameters of the equations;
    /// `None` in place of the varying parameter if it is none of them.
    ///
    /// # Errors
    /// [`ResponseError`].
    fn check_values_but(
        &self,
        known: &[Symbol],
        parameter: Option<Symbol>,
    ) -> Result<(), ResponseError> {
        if let Some(parameter) = parameter.filter(|name| !known.contains(name)) {
            return Err(ResponseError::NoParameter { name: parameter, known: known.to_vec() });
        }
        if self.values.get(self.parameter).is_some() {
            return Err(ResponseError::Given(self.parameter));
        }
        if let Some((unknown, _)) = self.values.iter().find(|(name, _)| !known.contains(name)) {
            return Err(ResponseError::Unknown(unknown));
        }
        let missing =
            |name: &&Symbol| Some(**name) != parameter && self.values.get(**name).is_none();
        let missing: Vec<Symbol> = known.iter().filter(missing).copied().collect();
        if !missing.is_empty() {
            return Err(ResponseError::Missing(missing));
        }
        let [low, high] = self.range;
        if !(low < high && (high - low).is_finite()) {
            return Err(ResponseError::Range(self.parameter));
        }
        for (what, given, most) in [
            ("the number of harmonics", self.harmonics.unwrap_or(1), MOST_HARMONICS),
            ("the number of periods", self.periods, MOST_PERIODS),
        ] {
            if !(1..=most).contains(&given) {
                return Err(ResponseError::Count { what, given, most });
            }
        }
        Ok(())
    }

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
            equations: Equations::parse(equation)?,
            of: None,
            along: None,
            walls: vec![],
            events: vec![],
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A strong drive takes a cubic spring through more swings in a period than the search has values for:
    /// that part of the range is left out, and said.
    #[test]
    fn a_range_over_decades_is_answered_in_part() {
        let equation = "x'' + x'/10 + x + x^3 = F*cos(t)";
        let part = |range: [f64; 2]| {
            let question = ResponseRequest::new(equation, "F", range, "").expect("a request");
            let oscillator = question.equations.oscillator().expect("one");
            let (covered, left_out) = covered_part(&question, oscillator).expect("a part");
            (covered.range, left_out)
        };
        let ([from, to], left_out) = part([0.0, 1e6]);
        assert_eq!((from, left_out), (0.0, vec![[to, 1e6]]));
        // By hand, n = sqrt(3 F^(2/3) 0.7131) swings: 24 values are one swing apart from n = 1 on.
        assert!((20.0..27.0).contains(&((3.0 * 0.7131_f64).sqrt() * to.cbrt())), "{to}");
        let ([from, to], left_out) = part([-1e6, 1e6]);
        assert!(-from > 500.0 && to > 500.0, "{from} {to}");
        assert_eq!(left_out, vec![[-1e6, from], [to, 1e6]]);
        assert_eq!(part([0.0, 100.0]), ([0.0, 100.0], vec![]));
        assert_eq!(part([0.0, 4000.0]), ([0.0, 4000.0], vec![]));
    }
}

//! Periodic impact orbits: motions that are linear between impacts on rigid walls, and repeat
//! themselves after some periods of the drive.
//!
//! In: a linear driven oscillator and its walls, an [`ImpactEquation`]. Out: in letters the impact
//! speed, its phase and the multipliers of orbits with one impact, with the curves at which they
//! begin, [`laws`]; in numbers all orbits, each beside a simulation, [`find_orbits`], and a proof of each,
//! [`certify_orbits`].
//!
//! ```text
//! x'' + c x' + k x = P + A cos(omega t) + B sin(omega t)   off the walls
//! x' -> -e x'                                              relative to a wall, at it
//! ```
//!
//! ```
//! # use lindstedt_impact as lindstedt;
//! use lindstedt::{Oscillator, orbits::{ImpactEquation, OrbitRequest, find_orbits}, wall::Wall};
//!
//! let beam = Oscillator::parse("x'' + c*x' + k*x = F*cos(w*t)")?;
//! let wall = Wall::parse("x < d", &"e".parse()?)?;
//! let question = ImpactEquation::new(&beam, &wall)?;
//! let values = "c = 0.1, k = 1, F = 0.5, w = 1, d = 1, e = 0.8".parse()?;
//! let found = find_orbits(&question, &values, &OrbitRequest::default())?;
//! let fast = &found.orbits[0];
//! assert!((fast.orbit.impacts[0].speed - 0.837_016_023_2).abs() < 1e-9);
//! assert!(fast.verdict.as_ref().is_some_and(|verdict| verdict.return_error < 1e-10));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod certify;
mod chart;
mod contour;
mod equation;
mod error;
mod family;
mod flow;
mod judge;
mod letters;
mod multipliers;
mod one_impact;
mod orbit;
mod search;
mod sweep;

pub use certify::{OrbitProofs, certify_orbits};
pub use chart::{CHART_SIZE, ChartPoint, OrbitChart, OrbitCurve, chart_orbits};
pub use equation::{
    BiasedHarmonic, CompiledImpact, ImpactEquation, ImpactNumbers, OrbitWall, WallNumbers,
};
pub use error::OrbitError;
pub use family::{OrbitChange, OrbitFamily};
pub use judge::OrbitVerdict;
pub use letters::{OrbitLaws, OrbitRelation};
pub use multipliers::OrbitStability;
pub use orbit::{ImpactOrbit, Obstacle, OrbitImpact, OrbitKind};
pub use sweep::{
    BranchPoint, OrbitBranch, OrbitChangePoint, OrbitSweep, VaryingParameter, sweep_orbits,
};

use crate::interrupt::Interrupt;
use crate::system::Integrator;
use crate::trajectory::TrajectoryRequest;
use crate::values::Values;
use crate::verify::{DEFAULT_TOLERANCE, Verdict};
use crate::wall::Wall;
use flow::WalledFlow;
use search::Search;

/// The largest number of periods of an orbit.
pub const MOST_PERIODS: u32 = 100;

/// The largest number of impacts of an orbit that is searched.
pub const MOST_IMPACTS: u32 = 20;

/// The orbits that are asked for.
#[derive(Clone, Debug)]
pub struct OrbitRequest {
    /// The number of impacts in a period of the orbit: one in closed form, with symmetric orbits
    /// between two walls; more by a search.
    pub impacts: u32,
    /// The least and the greatest number of periods of the drive.
    pub periods: [u32; 2],
    /// The largest error that passes.
    pub tolerance: f64,
    /// The request to stop the work.
    pub interrupt: Interrupt,
}

impl Default for OrbitRequest {
    /// One impact in one to three periods, the usual tolerance.
    fn default() -> Self {
        Self {
            impacts: 1,
            periods: [1, 3],
            tolerance: DEFAULT_TOLERANCE,
            interrupt: Interrupt::default(),
        }
    }
}

/// An orbit beside the simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedImpactOrbit {
    /// The orbit.
    pub orbit: ImpactOrbit,
    /// The verdict; `None` of an orbit that no motion follows.
    pub verdict: Option<OrbitVerdict>,
}

/// The orbits at given values.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundOrbits {
    /// The values.
    pub at: Values,
    /// The number of impacts in a period of an orbit.
    pub impacts: u32,
    /// The numbers of periods searched, least and greatest.
    pub periods: [u32; 2],
    /// The frequency of the drive.
    pub frequency: f64,
    /// The orbits: fewer periods first, then the faster.
    pub orbits: Vec<JudgedImpactOrbit>,
    /// Numbers of periods in which the free motion returns to itself, so that there is no orbit.
    pub degenerate: Vec<u32>,
    /// The largest error that passes.
    pub tolerance: f64,
    /// Whether every admissible orbit passes; `None` if there is none.
    pub verdict: Option<Verdict>,
}

/// Derives the laws of one-impact orbits, for each wall; of two walls placed alike those of
/// symmetric orbits as well.
///
/// # Errors
/// [`OrbitError::Expression`].
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::{Oscillator, orbits::{ImpactEquation, laws}, wall::Wall};
///
/// let ball = Oscillator::parse("x'' + g = 0")?;
/// let table = Wall::parse("x > Z*sin(w*t)", &"e".parse()?)?;
/// let laws = laws(&ImpactEquation::new(&ball, &table)?)?;
/// let speed = &laws[0].relations[0];
/// assert_eq!(format!("{} = {}", speed.left, speed.right), "v = g*T/(1 + e)");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn laws(question: &ImpactEquation) -> Result<Vec<OrbitLaws>, OrbitError> {
    let mut laws = Vec::new();
    if question.is_symmetric()? {
        laws.push(letters::derive(question, 0, OrbitKind::Symmetric)?);
    }
    for wall in 0..question.walls.len() {
        laws.push(letters::derive(question, wall, OrbitKind::OneImpact)?);
    }
    Ok(laws)
}

/// Finds the orbits at these values of all parameters, and judges each by a simulation.
///
/// # Errors
/// [`OrbitError`]: a missing or unknown value, one out of range, an undamped resonance.
pub fn find_orbits(
    question: &ImpactEquation,
    values: &Values,
    request: &OrbitRequest,
) -> Result<FoundOrbits, OrbitError> {
    sweep::check_periods(request.periods)?;
    if !(1..=MOST_IMPACTS).contains(&request.impacts) {
        let value = request.impacts;
        return Err(OrbitError::Count { what: "the impacts", value, most: MOST_IMPACTS });
    }
    let numbers = question.numbers(values)?;
    let (orbits, degenerate) = match request.impacts {
        1 => in_closed_form(question, &numbers, request.periods)?,
        _ => (searched(question, &numbers, request)?, vec![]),
    };
    let orbits = judged(question, values, &numbers, orbits, request)?;
    let mut verdicts = orbits.iter().filter(|own| own.orbit.is_admissible()).peekable();
    let verdict = verdicts.peek().is_some().then(|| {
        let passes = |own: &JudgedImpactOrbit| {
            own.verdict.as_ref().is_some_and(|own| own.verdict == Verdict::Pass)
        };
        Verdict::from_passed(verdicts.all(passes))
    });
    Ok(FoundOrbits {
        at: values.clone(),
        impacts: request.impacts,
        periods: request.periods,
        frequency: numbers.frequency,
        orbits,
        degenerate,
        tolerance: request.tolerance,
        verdict,
    })
}

/// All orbits in closed form, and the numbers of periods in which the free motion returns to itself.
fn in_closed_form(
    question: &ImpactEquation,
    numbers: &ImpactNumbers,
    [least, greatest]: [u32; 2],
) -> Result<(Vec<ImpactOrbit>, Vec<u32>), OrbitError> {
    let resonance = || OrbitError::Resonance(question.frequency.clone());
    let mut orbits = match question.is_symmetric()? {
        true => one_impact::symmetric_orbits(numbers, least..=greatest).ok_or_else(resonance)?,
        false => vec![],
    };
    let (one_impact, degenerate) =
        one_impact::one_impact_orbits(numbers, least..=greatest).ok_or_else(resonance)?;
    orbits.extend(one_impact);
    Ok((orbits, degenerate))
}

/// The orbits of several impacts that a search finds; those in closed form are left out.
fn searched(
    question: &ImpactEquation,
    numbers: &ImpactNumbers,
    request: &OrbitRequest,
) -> Result<Vec<ImpactOrbit>, OrbitError> {
    let mut orbits = Vec::new();
    let [least, greatest] = request.periods;
    let symmetric = match request.impacts == 2 && question.is_symmetric()? {
        true => one_impact::symmetric_orbits(numbers, least..=greatest).unwrap_or_default(),
        false => vec![],
    };
    let is_symmetric = |orbit: &ImpactOrbit| {
        symmetric.iter().any(|own| own.periods == orbit.periods && own.is_same(orbit))
    };
    for periods in least..=greatest {
        let search = Search::new(numbers, request.impacts, periods)
            .ok_or(OrbitError::Resonance(question.frequency.clone()))?;
        orbits
            .extend(search.orbits(request.interrupt).into_iter().filter(|own| !is_symmetric(own)));
        if request.interrupt.is_requested() {
            return Err(OrbitError::Interrupted);
        }
    }
    let mut all: Vec<ImpactOrbit> =
        symmetric.into_iter().filter(ImpactOrbit::is_admissible).chain(orbits).collect();
    all.sort_by_key(|orbit| orbit.periods);
    Ok(all)
}

/// The orbits, each admissible one beside its simulation.
fn judged(
    question: &ImpactEquation,
    values: &Values,
    numbers: &ImpactNumbers,
    orbits: Vec<ImpactOrbit>,
    request: &OrbitRequest,
) -> Result<Vec<JudgedImpactOrbit>, OrbitError> {
    let walls: Vec<Wall> = question.walls.iter().map(|wall| wall.wall.clone()).collect();
    let mut course = TrajectoryRequest::of_equation(&question.oscillator).with_walls(walls);
    course.values = values.numbers();
    course.interrupt = request.interrupt;
    let simulation = course.prepared(Integrator::Taylor)?;
    let walled =
        WalledFlow::new(numbers).ok_or(OrbitError::Resonance(question.frequency.clone()))?;
    let judged = orbits.into_iter().map(|orbit| {
        if request.interrupt.is_requested() {
            return Err(OrbitError::Interrupted);
        }
        let start = orbit.impacts[0].state_after(&walled);
        let verdict = match orbit.is_admissible() {
            true => judge::judge(&simulation, &orbit, start, numbers.frequency, request.tolerance),
            false => None,
        };
        Ok(JudgedImpactOrbit { orbit, verdict })
    });
    judged.collect()
}

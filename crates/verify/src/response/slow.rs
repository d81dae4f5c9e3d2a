//! Steady motions by the slow equations of a method, compared with the branches of a response.
//!
//! In: a [`ResponseDiagram`] and a [`Solution`] with slow equations of the primary resonance, such
//! as that of multiple scales. Out: its steady motions over the range, and their errors at the
//! stable points of the branches, whose true motions are known.

use super::bifurcation::BifurcationKind;
use super::{ResponseDiagram, ResponseRequest, SteadyMotion};
use crate::solution::Solution;
use crate::solution::response::{SteadyMotions, SteadyState};
use crate::symbol::Symbol;
use crate::verify::Verdict;

/// Largest relative difference in amplitude; beyond it the steady motion is another one, as when a
/// branch folds back too early.
const OTHER: f64 = 0.3;

/// Ratio to the largest amplitude below which an amplitude is zero.
const NOTHING: f64 = 1e-9;

/// One in so many stable points may be missing, because folds are shifted.
const MISSING: usize = 20;

/// Number of values of the parameter at which the slow equations are solved.
const VALUES: u32 = 240;

/// Steady motions by slow equations.
#[derive(Clone, Debug, PartialEq)]
pub struct SlowResponse {
    /// The solution with the slow equations and their method.
    pub solution: Box<Solution>,
    /// The steady motions, by the parameter, the largest first.
    pub states: Vec<SlowState>,
    /// The largest error of the amplitude at the stable points of the branches, over the amplitude
    /// there.
    pub error: Option<f64>,
    /// The parameter at that point.
    pub worst: Option<f64>,
    /// Stable points of the branches near which the slow equations have no stable motion.
    pub missing: usize,
    /// Values of the parameter at which steady motions of the truncated slow equations are [left
    /// out](Solution::steady_motions), the lowest and the highest amplitude of these; `None` if
    /// there are none.
    pub spurious: Option<Spurious>,
    /// Number of stable points.
    pub points: usize,
    /// Number of stable points beside a branch point, which are not compared: there the amplitude
    /// grows as a root of the distance, and a branch point that lies a little aside is a large error.
    pub beside: usize,
    /// Whether the error is within the tolerance and no more than one point in twenty is missing.
    pub verdict: Verdict,
}

/// Spurious steady motions, which only the truncation of the slow equations has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spurious {
    /// Their number, summed over all values of the parameter.
    pub count: usize,
    /// Their lowest and their highest amplitude.
    pub amplitudes: [f64; 2],
}

impl Spurious {
    fn from_states(found: &[SteadyState]) -> Option<Self> {
        let amplitudes = || found.iter().map(|state| state.amplitude);
        let lowest = amplitudes().min_by(f64::total_cmp)?;
        Some(Self { count: found.len(), amplitudes: [lowest, amplitudes().fold(lowest, f64::max)] })
    }
}

/// A steady motion by slow equations.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "SlowPoint"))]
pub struct SlowState {
    /// The value of the parameter that varies.
    pub parameter: f64,
    /// The amplitude of the first harmonic.
    pub amplitude: f64,
    /// Its phase, in radians.
    pub phase: f64,
    /// Whether small disturbances die out, by the slow equations.
    pub stable: bool,
}

/// The steady motions by these slow equations at one value of the parameter.
fn motions_at(question: &ResponseRequest, solution: &Solution, parameter: f64) -> SteadyMotions {
    let numbers = question.values.numbers();
    let value_of = |name: Symbol| match name == question.parameter {
        true => Some(parameter),
        false => numbers.get(&name).copied(),
    };
    solution.steady_motions(&value_of)
}

impl ResponseDiagram {
    /// Returns this response with the steady motions of these slow equations added.
    ///
    /// ```
    /// # use lindstedt_verify as lindstedt;
    /// use lindstedt::response::{ResponseRequest, respond};
    /// use lindstedt::{Method, Options, solve};
    ///
    /// let question = ResponseRequest::new("x'' + x'/25 + x + x^3/20 = cos(Omega*t)/20", "Omega", [0.8, 1.2], "")?;
    /// let options = Options { method: Some(Method::MultipleScales), ..Options::default() };
    /// let solution = solve(question.equations.oscillator().ok_or("several coordinates")?, &options)?;
    /// let response = respond(&question)?.with_slow_equations(solution);
    /// let slow = response.slow.ok_or("slow equations")?;
    /// assert!(slow.error.is_some_and(|error| error < 0.3) && slow.points > 20);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_slow_equations(mut self, solution: Solution) -> Self {
        let question = &self.question;
        let [low, high] = question.range;
        let value = |index: u32| low + (high - low) * f64::from(index) / f64::from(VALUES);
        let (mut states, mut spurious) = (vec![], vec![]);
        for parameter in (0..=VALUES).map(value) {
            let found = motions_at(question, &solution, parameter);
            states.extend(found.states.into_iter().map(|state| SlowState {
                parameter,
                amplitude: state.amplitude,
                phase: state.phase,
                stable: state.is_stable(),
            }));
            spurious.extend(found.spurious);
        }
        let (mut error, mut worst, mut missing, mut count, mut beside) =
            (None::<f64>, None, 0, 0, 0);
        let points = || self.branches.iter().flat_map(|branch| &branch.points);
        // At rest an amplitude is zero up to rounding.
        let smallest = NOTHING * points().map(|point| point.amplitude).fold(0.0, f64::max);
        for point in points().filter(|point| point.stable == Some(true)) {
            if self.is_beside_branch_point(point) {
                beside += 1;
                continue;
            }
            count += 1;
            let stable = motions_at(question, &solution, point.parameter).states.into_iter();
            let apart = stable
                .filter(SteadyState::is_stable)
                .map(|state| (state.amplitude - point.amplitude).abs())
                .min_by(f64::total_cmp);
            let relative =
                apart.map(|apart| apart / point.amplitude.max(smallest.max(f64::MIN_POSITIVE)));
            let Some(relative) = relative.filter(|relative| *relative <= OTHER) else {
                missing += 1;
                continue;
            };
            if error.is_none_or(|error| relative > error) {
                (error, worst) = (Some(relative), Some(point.parameter));
            }
        }
        self.slow = Some(SlowResponse {
            solution: Box::new(solution),
            states,
            verdict: Verdict::from_passed(
                MISSING * missing <= count
                    && error.is_some_and(|error| error <= question.tolerance),
            ),
            error,
            worst,
            missing,
            spurious: Spurious::from_states(&spurious),
            points: count,
            beside,
        });
        self
    }

    /// Whether a point is near a branch point, in the parameter and in the amplitude.
    fn is_beside_branch_point(&self, point: &SteadyMotion) -> bool {
        /// Distances, as fractions of the range and of the largest amplitude.
        const NEAR: f64 = 0.1;
        const SMALL: f64 = 0.5;
        let [low, high] = self.question.range;
        let points = self.branches.iter().flat_map(|branch| &branch.points);
        let largest = points.map(|point| point.amplitude).fold(0.0, f64::max);
        self.bifurcations.iter().any(|found| {
            found.kind == BifurcationKind::BranchPoint
                && (point.parameter - found.parameter).abs() <= NEAR * (high - low)
                && (point.amplitude - found.amplitude).abs() <= SMALL * largest
        })
    }
}

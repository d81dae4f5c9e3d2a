//! Steady motions by the slow equations of a method, compared with the branches of a response.
//!
//! In: a [`ResponseDiagram`] and a [`Solution`] with slow equations of the primary resonance, such
//! as that of multiple scales. Out: its steady motions over the range, and their errors at the
//! stable points of the branches, whose true motions are known.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use super::bifurcation::BifurcationKind;
use super::{ResponseDiagram, ResponseRequest, SteadyMotion};
use crate::expr::{CompiledList, Expr};
use crate::multiple_scales::{SlowMotion, SlowNumbers, SlowSteadyState};
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
    /// The slow equations and their method.
    pub equations: SlowEquations,
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

/// Slow equations of one coordinate or of several.
#[derive(Clone, Debug, PartialEq)]
pub enum SlowEquations {
    /// The solution of one coordinate that has them.
    One(Box<Solution>),
    /// Those of the modes of coupled equations.
    Coupled(Box<SlowMotion>),
}

impl SlowEquations {
    /// The method and its order.
    pub fn title(&self) -> String {
        match self {
            Self::One(solution) => solution.title(),
            Self::Coupled(slow) => slow.title(),
        }
    }
}

/// Stable points of branches beside the stable motions of slow equations.
#[derive(Default)]
struct Compared {
    error: Option<f64>,
    worst: Option<f64>,
    missing: usize,
    points: usize,
    beside: usize,
    tolerance: f64,
}

impl Compared {
    fn response(self, equations: SlowEquations, states: Vec<SlowState>) -> SlowResponse {
        SlowResponse {
            equations,
            states,
            verdict: Verdict::from_passed(
                MISSING * self.missing <= self.points
                    && self.error.is_some_and(|error| error <= self.tolerance),
            ),
            error: self.error,
            worst: self.worst,
            missing: self.missing,
            spurious: None,
            points: self.points,
            beside: self.beside,
        }
    }
}

/// The quantity that a response of coupled equations lists, by slow equations.
struct ListedQuantity {
    /// The quantity at the time, the amplitudes and phases, and the values of all letters.
    quantity: CompiledList,
    letters: Vec<Symbol>,
    values: BTreeMap<Symbol, f64>,
    parameter: Symbol,
    /// The frequency of the drive over the number of its periods in a period of the motion.
    base: Expr,
}

impl ListedQuantity {
    fn new(question: &ResponseRequest, slow: &SlowMotion) -> Result<Self, Symbol> {
        let t = Symbol::new("t");
        let coordinates = &slow.system.equations.coordinates;
        let motion: BTreeMap<Symbol, Expr> =
            coordinates.iter().copied().zip(slow.motion.iter().cloned()).collect();
        let first = coordinates.first().copied().unwrap_or(t);
        let of = question.of.clone().unwrap_or_else(|| Expr::from(first));
        let quantity = of.substitute_all(&motion).map_err(|_| first)?;
        let values = question.values.numbers();
        let named = slow.definitions.iter().chain(&slow.detunings).map(|known| known.symbol);
        let letters: Vec<Symbol> = values
            .keys()
            .copied()
            .chain([question.parameter])
            .chain(named)
            .chain([Symbol::new("pi")])
            .collect();
        let arguments: Vec<Symbol> = std::iter::once(t)
            .chain(slow.amplitudes.iter().chain(&slow.phases).copied())
            .chain(letters.iter().copied())
            .collect();
        let quantity = CompiledList::new(&[quantity], &arguments).map_err(|_| first)?;
        let base = slow.base.clone().ok_or(first)?;
        Ok(Self { quantity, letters, values, parameter: question.parameter, base })
    }

    fn value_of(&self, name: Symbol, parameter: f64) -> Option<f64> {
        match name == self.parameter {
            true => Some(parameter),
            false => self.values.get(&name).copied(),
        }
    }

    fn numbers(&self, slow: &SlowMotion, parameter: f64) -> Result<SlowNumbers, Symbol> {
        slow.in_numbers(&|name| self.value_of(name, parameter))
    }

    /// A steady motion in the quantity: amplitude and phase of its first harmonic, and its peak.
    fn state(
        &self,
        slow: &SlowMotion,
        parameter: f64,
        state: &SlowSteadyState,
    ) -> Result<SlowState, Symbol> {
        const POINTS: usize = 128;
        let defined = slow.values(&|name| self.value_of(name, parameter))?;
        let value = |name: &Symbol| {
            let defined = defined.iter().find(|(known, _)| known == name).map(|(_, value)| *value);
            let pi = (name.name() == "pi").then_some(PI);
            defined.or_else(|| self.value_of(*name, parameter)).or(pi).ok_or(*name)
        };
        let letters: Vec<f64> = self.letters.iter().map(value).collect::<Result<_, _>>()?;
        let known = self.letters.iter().copied().zip(letters.iter().copied()).collect();
        let base = self.base.evaluate(&known).map_err(|_| self.parameter)?;
        let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut cosine, mut sine) = (0.0, 0.0);
        let mut arguments: Vec<f64> = std::iter::once(0.0)
            .chain(state.amplitudes.iter().chain(&state.phases).copied())
            .chain(letters)
            .collect();
        let mut stack = Vec::new();
        for point in 0..POINTS {
            let theta = TAU * point as f64 / POINTS as f64;
            arguments[0] = theta / base;
            let mut found = [f64::NAN];
            self.quantity.call(&arguments, &mut stack, &mut found);
            (lowest, highest) = (lowest.min(found[0]), highest.max(found[0]));
            cosine += 2.0 * found[0] * theta.cos() / POINTS as f64;
            sine += 2.0 * found[0] * theta.sin() / POINTS as f64;
        }
        let amplitude = f64::hypot(cosine, sine);
        // What rounding leaves of a quantity that has no first harmonic.
        let none = amplitude <= 1e-12 * (highest - lowest);
        Ok(SlowState {
            parameter,
            amplitude: if none { 0.0 } else { amplitude },
            phase: sine.atan2(cosine),
            stable: state.is_stable(),
            peak: Some(0.5 * (highest - lowest)),
        })
    }
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
    /// Half of the way from the lowest to the highest point, of coupled equations; left out of one
    /// coordinate.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub peak: Option<f64>,
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
                peak: None,
            }));
            spurious.extend(found.spurious);
        }
        let near = |parameter: f64| -> Vec<f64> {
            let found = motions_at(question, &solution, parameter).states.into_iter();
            found.filter(SteadyState::is_stable).map(|state| state.amplitude).collect()
        };
        let compared = self.compared(&near, &|point| point.amplitude);
        let spurious = Spurious::from_states(&spurious);
        self.slow = Some(SlowResponse {
            spurious,
            ..compared.response(SlowEquations::One(Box::new(solution)), states)
        });
        self
    }

    /// Returns this response of coupled equations with the steady motions of these slow equations
    /// added, compared in half of the way from the lowest to the highest point.
    ///
    /// # Errors
    /// The first symbol without a value, or a quantity that has none.
    pub fn with_slow_motion(mut self, slow: SlowMotion) -> Result<Self, Symbol> {
        /// Random starts at the first value, and at each of the others, for each mode.
        const FIRST: usize = 1000;
        const OTHERS: usize = 20;
        let question = &self.question;
        let listed = ListedQuantity::new(question, &slow)?;
        let [low, high] = question.range;
        let mut known: Vec<(f64, Vec<SlowSteadyState>)> = Vec::new();
        let mut states = Vec::new();
        for index in 0..=VALUES {
            if question.interrupt.is_requested() {
                break;
            }
            let parameter = low + (high - low) * f64::from(index) / f64::from(VALUES);
            let numbers = listed.numbers(&slow, parameter)?;
            let last = known.last().map_or(&[][..], |(_, states)| states.as_slice());
            let starts = if index == 0 { FIRST } else { OTHERS } * slow.amplitudes.len();
            let found = numbers.steady_states_near(last, starts, question.interrupt).isolated;
            for state in found.iter().filter(|state| slow.driven_frequency(state).is_some()) {
                states.push(listed.state(&slow, parameter, state)?);
            }
            known.push((parameter, found));
        }
        let near = |parameter: f64| -> Vec<f64> {
            let apart = |place: &f64| (place - parameter).abs();
            let nearest =
                known.iter().min_by(|(one, _), (other, _)| apart(one).total_cmp(&apart(other)));
            let (Some((_, start)), Ok(numbers)) = (nearest, listed.numbers(&slow, parameter))
            else {
                return vec![];
            };
            let found = numbers.steady_states_near(start, 0, question.interrupt);
            let found = found.isolated.into_iter();
            found
                .filter(|state| state.is_stable() && slow.driven_frequency(state).is_some())
                .filter_map(|state| listed.state(&slow, parameter, &state).ok()?.peak)
                .collect()
        };
        let compared = self.compared(&near, &|point| point.peak);
        self.slow = Some(compared.response(SlowEquations::Coupled(Box::new(slow)), states));
        Ok(self)
    }

    /// The stable points of the branches beside the sizes of the stable motions that `near` gives at a
    /// value of the parameter.
    fn compared(
        &self,
        near: &dyn Fn(f64) -> Vec<f64>,
        size: &dyn Fn(&SteadyMotion) -> f64,
    ) -> Compared {
        let mut compared = Compared { tolerance: self.question.tolerance, ..Compared::default() };
        let points = || self.branches.iter().flat_map(|branch| &branch.points);
        // At rest an amplitude is zero up to rounding.
        let smallest = NOTHING * points().map(size).fold(0.0, f64::max);
        for point in points().filter(|point| point.stable == Some(true)) {
            if self.is_beside_branch_point(point) {
                compared.beside += 1;
                continue;
            }
            compared.points += 1;
            let own = size(point);
            let apart = near(point.parameter)
                .into_iter()
                .map(|size| (size - own).abs())
                .min_by(f64::total_cmp);
            let relative = apart.map(|apart| apart / own.max(smallest.max(f64::MIN_POSITIVE)));
            let Some(relative) = relative.filter(|relative| *relative <= OTHER) else {
                compared.missing += 1;
                continue;
            };
            if compared.error.is_none_or(|error| relative > error) {
                (compared.error, compared.worst) = (Some(relative), Some(point.parameter));
            }
        }
        compared
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

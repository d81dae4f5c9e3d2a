//! Kind `response`: all steady states of an oscillator, driven or self-excited, or of coupled
//! equations, with their stability.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::motion::{EventDocument, WallDocument};
use super::number::{Constant, Map, constants, is_nothing, meanings};
use crate::report::{listed_quantity, motion_frequency};
use crate::response::slow::{SlowEquations, SlowResponse};
use crate::response::{self, CoordinateMotion, ResponseDiagram};
#[cfg(feature = "schema")]
use crate::verify::Verdict;

/// Steady states of an oscillator, or of coupled equations, as a parameter varies. Units are those
/// of the equation and the values given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ResponseDocument {
    /// The kind of document.
    pub schema: String,
    /// The equation of motion; coupled equations are separated by `;`.
    pub equation: String,
    /// The coordinates of coupled equations, without those that only count. Left out for one coordinate.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub coordinates: Vec<String>,
    /// The states that only count: they enter neither forces nor conditions. Left out where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub counters: Vec<String>,
    /// The values of each state that changes at events alone, among finitely many. Left out where there is none.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub modes: Map<Vec<f64>>,
    /// The quantity of coupled equations whose amplitude, phase and peak are listed, in the
    /// coordinates. Left out for one coordinate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// The values of all other parameters.
    pub parameters: Map<Constant>,
    /// The name of the parameter that varies.
    pub parameter: String,
    /// Its lowest and its highest value.
    pub range: [f64; 2],
    /// How the branches were found: `harmonic-balance`, or `period-map` where the force has corners,
    /// or jumps that harmonic balance does not take; `shooting` for coupled equations.
    pub method: String,
    /// The highest harmonic kept.
    pub harmonics: usize,
    /// How many periods of the drive a period of the motion takes.
    pub periods: usize,
    /// theta/t: the frequency of the motion, that of the drive over `periods`; a name where nothing
    /// drives it.
    pub frequency: String,
    /// Whether nothing drives the motion: each point then has a frequency of its own, or, of coupled
    /// equations that nothing damps either, the parameter is the frequency.
    pub self_excited: bool,
    /// Whether nothing damps the motion; `stable` then means that disturbances do not grow.
    pub undamped: bool,
    /// The branches, each a list of points in order.
    pub branches: Vec<Vec<ResponsePoint>>,
    /// Of each branch whether -x half a period of the drive later is a branch as well, which is not
    /// listed.
    pub mirrored: Vec<bool>,
    /// Of each point of a branch the part of a period in which dry friction holds it or it rests on a
    /// wall; empty for a branch that nothing holds.
    pub stuck: Vec<Vec<f64>>,
    /// The walls; left out without one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub walls: Vec<WallDocument>,
    /// The number of impacts in a period at each point of a branch, without those that accumulate before
    /// a rest; left out without a wall.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub impacts: Vec<Vec<usize>>,
    /// The events, as `--event` takes them; left out without one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<EventDocument>,
    /// The number of events in a period at each point of a branch, without those that set nothing but what only
    /// counts; left out without an event.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub event_counts: Vec<Vec<usize>>,
    /// Where branches change.
    pub bifurcations: Vec<response::Bifurcation>,
    /// The equilibria of coupled equations that nothing drives, a branch each. Left out where there
    /// are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub equilibria: Vec<response::EquilibriumBranch>,
    /// The name of a second parameter, along which bifurcations are followed. Left out where none
    /// was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub along: Option<String>,
    /// The curves of bifurcations in both parameters. Left out where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curves_of_bifurcations: Vec<response::BifurcationCurve>,
    /// The numbers of stable motions over both parameters. Left out where they were not counted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stable_motions: Option<response::StableMotions>,
    /// Folds of the balance that are none of the true motion and not among those places. Left out
    /// where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ripple: Option<response::Ripple>,
    /// The free motion without damping, a list of points for each stable place of rest; empty where
    /// the frequency of the drive does not vary.
    pub backbone: Vec<Vec<response::backbone::BackbonePoint>>,
    /// The steady motions by slow equations of amplitude and phase, where a method with such
    /// equations was asked for; else null.
    pub modulation: Option<SlowDocument>,
    /// Simulations that were let go beside stable points and have settled.
    pub simulated: Vec<response::Simulated>,
    /// Simulations that have settled on something that is not among the branches.
    pub elsewhere: Vec<response::Elsewhere>,
    /// The judgement of all points.
    pub verification: ResponseVerification,
    /// Whether the search for motions of coupled equations was ended because it had taken as much work as it
    /// may: branches may be missing or end early, and bifurcations are not listed. Left out where it was not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub exhausted: bool,
    /// The stretches, each with its ends, in which the search for motions of one coordinate had too few
    /// starts: from one to the next they gain more than a swing in a period of the drive. Those outside
    /// `range` were asked for and are not answered; in others branches may be missing. Left out where there
    /// are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sparse: Vec<[f64; 2]>,
    /// Whether it was followed to its end.
    pub complete: bool,
}

/// A steady state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ResponsePoint {
    /// The value of the parameter that varies.
    pub parameter: f64,
    /// The frequency of the motion: theta/t.
    pub frequency: f64,
    /// The amplitude of the first harmonic, amplitude*cos(theta - phase).
    pub amplitude: f64,
    /// Its phase, in radians.
    pub phase: f64,
    /// Half of the way from the lowest to the highest point of the motion.
    pub peak: f64,
    /// Whether small disturbances die out: both multipliers lie inside the unit circle, of a
    /// self-excited motion the first; null where they could not be found.
    pub stable: Option<bool>,
    /// The multipliers of a period, each its real and imaginary part, the larger first, of a
    /// self-excited motion the one along it, which is 1, last; null where they could not be found.
    pub multipliers: Option<[[f64; 2]; 2]>,
    /// Position and velocity at t = 0, by shooting where that found the true motion.
    pub start: [f64; 2],
    /// The error of amplitude or peak, the larger, over the true peak, or that of the frequency;
    /// null where no true motion was found near.
    pub error: Option<f64>,
    /// The amplitude of the first harmonic of each coordinate of coupled equations. Left out for one
    /// coordinate.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub amplitudes: Map<f64>,
    /// The phase of each, in radians. Left out for one coordinate.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub phases: Map<f64>,
    /// Half of the way from the lowest to the highest point of each. Left out for one coordinate.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub peaks: Map<f64>,
    /// The positions of all coordinates at t = 0, then their rates. Left out for one coordinate.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub state: Vec<f64>,
    /// The value after a period of each state that only counts and begins the period at zero. Left out where there
    /// is none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub counted: Vec<f64>,
    /// The energy of a free motion without damping over that of rest. Left out where it is not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<f64>,
}

/// Steady motions by slow equations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "SlowResponse"))]
pub struct SlowDocument {
    /// The method: `multiple-scales`.
    pub method: String,
    /// Its order.
    pub order: u32,
    /// The rate of the amplitude, a formula; empty of coupled equations.
    pub amplitude_rate: String,
    /// The rate of the phase, a formula; empty of coupled equations.
    pub phase_rate: String,
    /// The rates of amplitude and phase of each mode of coupled equations, formulas. Left out of one
    /// coordinate.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub modes: Vec<[String; 2]>,
    /// What stands for what in them.
    pub definitions: Map<String>,
    /// The steady motions, by the parameter.
    pub states: Vec<response::slow::SlowState>,
    /// The largest error of the amplitude at the stable points of the branches, over the amplitude;
    /// null where there is none.
    pub largest_error: Option<f64>,
    /// Stable points of the branches near which the slow equations have no stable motion.
    pub missing: usize,
    /// The number of stable points beside a branch point, which are not compared: there the amplitude
    /// grows as a root of the distance. Left out where there are none.
    #[serde(default, skip_serializing_if = "is_nothing")]
    pub beside: usize,
    /// Steady motions of the truncated slow equations that are left out, at all values of the
    /// parameter together: at their amplitude the last order is more than half of the one before
    /// it. Left out where there are none.
    #[serde(default, skip_serializing_if = "is_nothing")]
    pub spurious: usize,
    /// Whether the error is within the tolerance and no more than one point in twenty is missing.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [Verdict::Pass.name(), Verdict::Fail.name()])))]
    pub verdict: String,
}

fn slow(slow: &SlowResponse) -> SlowDocument {
    let (method, order, rates, definitions) = match &slow.equations {
        SlowEquations::One(solution) => {
            let rates = solution.modulation.as_ref().map(|modulation| {
                [&modulation.amplitude_rate, &modulation.phase_rate].map(ToString::to_string)
            });
            let definitions = meanings(&solution.definitions);
            (solution.method, solution.order, rates.into_iter().collect(), definitions)
        }
        SlowEquations::Coupled(slow) => {
            let rates: Vec<[String; 2]> = (0..slow.rates.len())
                .filter_map(|mode| Some(slow.rate(mode).ok()?.map(|rate| rate.to_string())))
                .collect();
            let all: Vec<_> = slow.definitions.iter().chain(&slow.detunings).cloned().collect();
            let mut definitions = meanings(&all);
            for (index, (name, _)) in slow.slow_phases.iter().enumerate() {
                let meaning = slow.meaning(index).map(|meaning| meaning.to_string());
                definitions.extend(meaning.map(|meaning| (name.to_string(), meaning)));
            }
            let order = u32::try_from(slow.order).unwrap_or(u32::MAX);
            (crate::solution::Method::MultipleScales, order, rates, definitions)
        }
    };
    let of_one = || rates.first().cloned().filter(|_| rates.len() == 1).unwrap_or_default();
    let [amplitude_rate, phase_rate] = of_one();
    SlowDocument {
        method: method.name().to_owned(),
        order,
        amplitude_rate,
        phase_rate,
        modes: if rates.len() > 1 { rates } else { vec![] },
        definitions,
        states: slow.states.clone(),
        largest_error: slow.error,
        missing: slow.missing,
        beside: slow.beside,
        spurious: slow.spurious.map_or(0, |spurious| spurious.count),
        verdict: slow.verdict.name().to_owned(),
    }
}

/// How far the branches are from true motions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ResponseVerification {
    /// The largest error of all points and simulations; null where no true motion was found.
    pub error: Option<f64>,
    /// The error up to which it passes.
    pub tolerance: f64,
    /// Points beside which shooting found no true motion.
    pub unjudged: usize,
    /// The verdict.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [Verdict::Pass.name(), Verdict::Fail.name()])))]
    pub verdict: String,
}

fn point(point: &response::SteadyMotion) -> ResponsePoint {
    let each = |quantity: fn(&CoordinateMotion) -> f64| {
        let coordinates = point.coordinates.iter();
        coordinates.map(|motion| (motion.coordinate.to_string(), quantity(motion))).collect()
    };
    let starts = point.coordinates.iter().map(|motion| motion.start);
    let rates = point.coordinates.iter().map(|motion| motion.rate);
    ResponsePoint {
        parameter: point.parameter,
        frequency: point.frequency,
        amplitude: point.amplitude,
        phase: point.phase,
        peak: point.peak,
        stable: point.stable,
        multipliers: point.multipliers.map(|both| both.map(|one| [one.re, one.im])),
        start: point.start,
        error: point.error,
        amplitudes: each(|motion| motion.amplitude),
        phases: each(|motion| motion.phase),
        peaks: each(|motion| motion.peak),
        state: starts.chain(rates).collect(),
        counted: point.counted.clone(),
        energy: point.energy,
    }
}

/// A number at each point of the branches; nothing where there is nothing to be counted.
fn counts(
    response: &ResponseDiagram,
    is_counted: bool,
    count: fn(&response::SteadyMotion) -> usize,
) -> Vec<Vec<usize>> {
    let of_branch = |branch: &response::Branch| branch.points.iter().map(count).collect();
    match is_counted {
        true => response.branches.iter().map(of_branch).collect(),
        false => vec![],
    }
}

/// The part of a period that each point of a branch sticks; nothing for one that never does.
fn stuck(branch: &response::Branch) -> Vec<f64> {
    match branch.points.iter().any(|point| point.stuck > 0.0) {
        true => branch.points.iter().map(|point| point.stuck).collect(),
        false => vec![],
    }
}

/// The document of kind `response`.
///
/// ```
/// use lindstedt::response::{ResponseRequest, respond};
///
/// let question = ResponseRequest::new("x'' + x'/5 + x - cos(Omega*t) = 0", "Omega", [0.5, 1.5], "")?;
/// let document = lindstedt::export::json::response(&respond(&question)?);
/// assert!(document.branches.len() == 1 && document.verification.verdict == "pass");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn response(response: &ResponseDiagram) -> ResponseDocument {
    let asked = &response.question;
    let coupled = asked.equations.oscillator().is_none();
    let coordinates = match coupled {
        true => response.coordinates().iter().map(ToString::to_string).collect(),
        false => vec![],
    };
    ResponseDocument {
        schema: DocumentKind::Response.schema().to_owned(),
        equation: asked.equations.to_string(),
        coordinates,
        counters: response.counters.iter().map(ToString::to_string).collect(),
        modes: response
            .modes
            .iter()
            .map(|(name, values)| (name.to_string(), values.clone()))
            .collect(),
        of: coupled.then(|| listed_quantity(response)),
        parameters: constants(&asked.values),
        parameter: asked.parameter.to_string(),
        range: asked.range,
        method: match (coupled, response.by_map) {
            (true, _) => "shooting",
            (false, true) => "period-map",
            (false, false) => "harmonic-balance",
        }
        .to_owned(),
        harmonics: response.harmonics,
        periods: asked.periods,
        frequency: motion_frequency(response),
        self_excited: response.self_excited,
        undamped: response.undamped,
        branches: response
            .branches
            .iter()
            .map(|branch| branch.points.iter().map(point).collect())
            .collect(),
        mirrored: response.branches.iter().map(|branch| branch.mirrored).collect(),
        stuck: response.branches.iter().map(stuck).collect(),
        walls: asked.walls.iter().map(WallDocument::new).collect(),
        impacts: counts(response, !asked.walls.is_empty(), |point| point.impacts),
        events: asked.events.iter().map(EventDocument::new).collect(),
        event_counts: counts(response, response.has_events(), |point| point.events),
        bifurcations: response.bifurcations.clone(),
        equilibria: response.equilibria.clone(),
        along: asked.along.map(|(name, _)| name.to_string()),
        curves_of_bifurcations: response.curves.clone(),
        stable_motions: response.stable_motions.clone(),
        ripple: response.ripple,
        backbone: response.backbone.clone(),
        modulation: response.slow.as_ref().map(slow),
        simulated: response.simulated.clone(),
        elsewhere: response.elsewhere.clone(),
        verification: ResponseVerification {
            error: response.error,
            tolerance: asked.tolerance,
            unjudged: response.unjudged,
            verdict: response.verdict.name().to_owned(),
        },
        exhausted: response.exhausted,
        sparse: response.sparse.clone(),
        complete: response.complete,
    }
}

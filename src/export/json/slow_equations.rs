//! Kind `slow-equations`: amplitudes and phases of all modes of coupled equations that change slowly.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::{Constant, Map, constants, finite, meanings, named, texts};
use crate::expr::ExprError;
use crate::report::SlowReport;
use crate::solution::Method;
use crate::verify::{JudgedSteadyMotion, JudgedTransient};

/// The slow equations of coupled equations by multiple scales.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct SlowEquationsDocument {
    /// The kind of document.
    pub schema: String,
    /// The equations as they were understood.
    pub equations: Vec<String>,
    /// The coordinates.
    pub coordinates: Vec<String>,
    /// The place of rest from which each coordinate is counted, a formula.
    pub rest: Map<String>,
    /// The letters of the equations, in alphabetical order.
    pub parameters: Vec<String>,
    /// The method: `multiple-scales`, or `averaging`.
    pub method: String,
    /// The highest order of the slow equations.
    pub order: usize,
    /// The order as which damping, detunings and drives at a resonance count.
    pub small_order: usize,
    /// The small parameter; null if it is the amplitude of the motion.
    pub small_parameter: Option<String>,
    /// The resonances between the frequencies.
    pub resonances: Vec<String>,
    /// The modes.
    pub modes: Vec<SlowModeDocument>,
    /// The slow phases in the rates that are combinations of the phases of the modes.
    pub slow_phases: Map<String>,
    /// The motion of each coordinate: a formula in `t`, the amplitudes and the phases.
    pub motion: Map<String>,
    /// What the formulas name, each by those before it; detunings, `sigma`, are reference frequency less
    /// linear frequency.
    pub definitions: Map<String>,
    /// What stays constant along the slow motion, formulas in amplitudes and slow phases; empty where
    /// something damps or drives it, or no one phase decides.
    #[serde(default)]
    pub constants: Vec<String>,
    /// The relations of steady motions with the phases eliminated.
    pub relations: Vec<SteadyRelationDocument>,
    /// Waves that are near the frequency of a mode they are not in resonance with, where values are known: a
    /// divisor is small.
    pub near: Vec<NearDivisorDocument>,
    /// The derivation line by line, as text; left out where it was not asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derivation: Option<Vec<String>>,
    /// Whether coefficients are rounded to fifteen digits.
    pub numerical: bool,
    /// The values at which steady motions, or a motion, were computed; null without values.
    pub at: Option<Map<Constant>>,
    /// The steady motions at the values, the largest first.
    pub steady: Vec<SlowSteadyDocument>,
    /// Whether there are families of steady motions as well, which are not listed.
    pub has_families: bool,
    /// The motion from the amplitudes that were given, beside the true one; null without them.
    pub transient: Option<TransientDocument>,
    /// The measured exponent of the deviation by halving of everything that is small; left out where it
    /// was not measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slope: Option<f64>,
    /// `pass` or `fail`; null where nothing was compared.
    pub verdict: Option<String>,
    /// The largest error that passes; null without values.
    pub tolerance: Option<f64>,
}

/// A mode with the rates of its amplitude and phase.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "SlowMode"))]
pub struct SlowModeDocument {
    /// Its number.
    pub number: usize,
    /// Its linear frequency, a formula.
    pub frequency: String,
    /// The frequency with which its phase is counted, which obeys the resonances.
    pub reference_frequency: String,
    /// The linear mode: the displacement of each coordinate.
    pub shape: Map<String>,
    /// The symbol of its amplitude.
    pub amplitude: String,
    /// The symbol of its phase.
    pub phase: String,
    /// The rate of the amplitude, a formula.
    pub amplitude_rate: String,
    /// The rate of the phase, a formula.
    pub phase_rate: String,
}

/// A wave near the frequency of a mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "NearDivisor"))]
pub struct NearDivisorDocument {
    /// The number of the mode.
    pub mode: usize,
    /// The frequency of the wave, a formula.
    pub frequency: String,
    /// Its distance from that of the mode, as a part of it.
    pub distance: f64,
}

/// A relation between amplitudes of steady motions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "SteadyRelation"))]
pub struct SteadyRelationDocument {
    /// The amplitudes that are zero; the others are not.
    pub at_rest: Vec<String>,
    /// The formula that vanishes.
    pub vanishes: String,
    /// The amplitude that the relation fixes alone, and its square; else empty.
    pub squares: Map<String>,
}

/// A steady motion of the slow equations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "SlowSteadyMotion"))]
pub struct SlowSteadyDocument {
    /// The amplitude of each mode.
    pub amplitudes: Map<f64>,
    /// The phase of each mode at t = 0.
    pub phases: Map<f64>,
    /// The rate of each phase: zero where a drive fixes it.
    pub phase_rates: Map<f64>,
    /// Whether small disturbances die out, by the slow equations.
    pub stable: bool,
    /// The largest real part of the eigenvalues that decide; null where there are none.
    pub growth: Option<f64>,
    /// The largest deviation of a coordinate from the true motion over a period, as a part of the
    /// largest displacement; null where none was sought, or found near.
    pub error: Option<f64>,
    /// Whether the true motion is stable, by its multipliers; null where it is not known.
    pub truly_stable: Option<bool>,
    /// The frequency of a motion that nothing drives; left out of others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub omega: Option<f64>,
    /// The true frequency of a motion that nothing drives; left out where it was not found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub true_omega: Option<f64>,
}

/// A motion by the slow equations beside the true one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "SlowTransient"))]
pub struct TransientDocument {
    /// The time over which both are compared.
    pub until: f64,
    /// The largest deviation of a coordinate, as a part of the largest displacement.
    pub error: f64,
    /// The exchange of energy between the modes; null where there is none in closed form.
    #[serde(default)]
    pub exchange: Option<ExchangeDocument>,
}

/// The exchange of energy between modes in resonance, by the slow equations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "EnergyExchange"))]
pub struct ExchangeDocument {
    /// The period, `factor` times K(m).
    pub period: f64,
    /// The factor of K(m).
    #[serde(default)]
    pub factor: f64,
    /// The parameter m of the complete elliptic integral K(m).
    pub parameter: f64,
    /// The coefficients of f in s'^2 = f(s), the lowest first; s is zero at the start.
    #[serde(default)]
    pub rate_squared: Vec<f64>,
    /// The zeros of f between which s goes to and fro.
    #[serde(default)]
    pub ends: [f64; 2],
    /// The square of each amplitude, linear in s: its value at the start and its slope.
    #[serde(default)]
    pub squares: Map<[f64; 2]>,
    /// The least and the greatest amplitude of each mode.
    pub amplitudes: Map<[f64; 2]>,
}

/// The document of kind `slow-equations`.
///
/// # Errors
/// A step of algebra that fails.
///
/// ```
/// use lindstedt::multiple_scales::{CoupledSystem, MultipleScalesOptions, derive};
/// use lindstedt::report::SlowReport;
///
/// let system = CoupledSystem::parse("x'' + x - x*y = 0; y'' + w2^2*y - x^2 = 0")?;
/// let resonance = Some("w2 = 2*omega1".to_owned());
/// let slow = derive(&system, &MultipleScalesOptions { resonance, ..Default::default() })?;
/// let document = lindstedt::export::json::slow_equations(&SlowReport { slow: &slow, judged: None })?;
/// assert_eq!(document.modes[0].amplitude_rate, "-a1*a2*sin(gamma1)/4");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn slow_equations(report: &SlowReport) -> Result<SlowEquationsDocument, ExprError> {
    let slow = report.slow;
    let equations = &slow.system.equations;
    let sides = equations.equations.iter().map(|(left, right)| format!("{left} = {right}"));
    let formulas = |formulas: &[crate::expr::Expr]| -> Map<String> {
        named(equations.coordinates.iter().zip(formulas.iter().map(ToString::to_string)))
    };
    let mut modes = Vec::new();
    for mode in 0..slow.rates.len() {
        let [amplitude_rate, phase_rate] = slow.rate(mode)?.map(|rate| rate.to_string());
        modes.push(SlowModeDocument {
            number: mode + 1,
            frequency: slow.frequencies[mode].to_string(),
            reference_frequency: slow.references[mode].to_string(),
            shape: formulas(&slow.shapes[mode]),
            amplitude: slow.amplitudes[mode].to_string(),
            phase: slow.phases[mode].to_string(),
            amplitude_rate,
            phase_rate,
        });
    }
    let phases = slow.slow_phases.iter().enumerate();
    let phases = phases.filter_map(|(index, (name, _))| {
        Some((name.to_string(), slow.meaning(index)?.to_string()))
    });
    let relations = slow.steady_relations().into_iter().map(|relation| SteadyRelationDocument {
        at_rest: relation.at_rest.iter().map(|mode| slow.amplitudes[*mode].to_string()).collect(),
        vanishes: crate::expr::Expr::from(&relation.relation).to_string(),
        squares: relation
            .solved
            .into_iter()
            .map(|(name, square)| (name.to_string(), square.to_string()))
            .collect(),
    });
    let definitions: Vec<_> = slow.definitions.iter().chain(&slow.detunings).cloned().collect();
    let judged = report.judged;
    Ok(SlowEquationsDocument {
        schema: DocumentKind::SlowEquations.schema().to_owned(),
        equations: sides.collect(),
        coordinates: texts(&equations.coordinates),
        rest: formulas(&slow.system.rest),
        parameters: texts(&equations.parameters),
        method: match slow.averaging {
            true => Method::Averaging.name().to_owned(),
            false => Method::MultipleScales.name().to_owned(),
        },
        order: slow.order,
        small_order: slow.small_order,
        small_parameter: slow.system.small.map(|name| name.to_string()),
        resonances: slow.resonances.clone(),
        modes,
        slow_phases: phases.collect(),
        motion: formulas(&slow.motion),
        definitions: meanings(&definitions),
        constants: match (slow.invariants(), slow.slow_phases.first()) {
            (Some(invariants), Some((phase, _))) => {
                invariants.expressions(*phase)?.iter().map(ToString::to_string).collect()
            }
            _ => vec![],
        },
        relations: relations.collect(),
        near: slow
            .near
            .iter()
            .map(|near| NearDivisorDocument {
                mode: near.mode,
                frequency: near.frequency.to_string(),
                distance: near.distance,
            })
            .collect(),
        derivation: (!slow.derivation.is_empty())
            .then(|| slow.derivation.iter().map(ToString::to_string).collect()),
        numerical: slow.rounded,
        at: judged.map(|judged| constants(&judged.at)),
        steady: judged
            .iter()
            .flat_map(|judged| &judged.steady)
            .map(|motion| steady(report, motion))
            .collect(),
        has_families: judged.is_some_and(|judged| judged.has_families),
        transient: judged
            .and_then(|judged| judged.transient.as_ref())
            .map(|own| transient(report, own)),
        slope: judged.and_then(|judged| finite(judged.slope)),
        verdict: judged.and_then(|judged| judged.verdict).map(|verdict| verdict.name().to_owned()),
        tolerance: judged.map(|judged| judged.tolerance),
    })
}

fn steady(report: &SlowReport, motion: &JudgedSteadyMotion) -> SlowSteadyDocument {
    let state = &motion.state;
    let slow = report.slow;
    SlowSteadyDocument {
        amplitudes: named(slow.amplitudes.iter().zip(state.amplitudes.iter().copied())),
        phases: named(slow.phases.iter().zip(state.phases.iter().copied())),
        phase_rates: named(slow.phases.iter().zip(state.turning.iter().copied())),
        stable: state.is_stable(),
        growth: finite(state.growth),
        error: finite(motion.error),
        truly_stable: motion.truly_stable,
        omega: motion.frequency.map(|(own, _)| own),
        true_omega: motion.frequency.and_then(|(_, truth)| finite(truth)),
    }
}

fn transient(report: &SlowReport, judged: &JudgedTransient) -> TransientDocument {
    let exchange = judged.exchange.as_ref().map(|exchange| ExchangeDocument {
        period: exchange.period,
        factor: exchange.factor,
        parameter: exchange.parameter,
        rate_squared: exchange.rate_squared.clone(),
        ends: exchange.ends,
        squares: named(report.slow.amplitudes.iter().zip(exchange.squares.iter().copied())),
        amplitudes: named(report.slow.amplitudes.iter().zip(exchange.amplitudes.iter().copied())),
    });
    TransientDocument { until: judged.until, error: judged.error, exchange }
}

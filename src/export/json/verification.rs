//! The verification of a formula, inside the documents of kind `solution`: frequencies and errors
//! at the given values, the steady or the transient motion, the range, the verdict.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number::{constants, finite, is_nothing, named, text};
use super::{Constant, Map};
use crate::exact::Doubles;
use crate::export::rounding_noise;
use crate::series::FourierSeries;
use crate::verify::validity::Range;
use crate::verify::{self, Followed};

/// A formula at given values, beside the true motion of the equation as it was typed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Verification {
    /// The values that were given.
    pub at: Map<Constant>,
    /// omega by the formula, in radians per unit of time; null where there is none.
    pub frequency: Option<f64>,
    /// Why there is no frequency, in words; null where there is one.
    pub reason: Option<String>,
    /// omega of the true motion, in radians per unit of time.
    pub true_frequency: f64,
    /// frequency / true_frequency - 1, signed, as a fraction; null where there is no frequency.
    pub relative_error: Option<f64>,
    /// What is judged: `omega^2`, of which the frequency is the root, or `omega`; of a driven
    /// motion the `amplitude` of the largest stable steady state, whose relative error is given.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["omega^2", "omega", "amplitude"])))]
    pub judged_on: String,
    /// The relative error of `frequency` where `frequency_squared` is judged; null where they do
    /// not stand side by side.
    pub error_of_omega: Option<f64>,
    /// The largest |x - x_true| over one true period in real time, as a fraction of the amplitude;
    /// null where it is not known.
    pub max_deviation: Option<f64>,
    /// Why the displacement is not judged, in words. Left out where it is, or where there is none
    /// to judge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_deviation: Option<String>,
    /// The root mean square of what the formula leaves of the equation, over that of the force;
    /// null where it is not known.
    pub residual: Option<f64>,
    /// The exponent with which the error of the frequency vanishes as the small parameter does; of
    /// a motion followed from its start that of `max_deviation`, over times that grow as the small
    /// parameter becomes less, and of a steady driven motion that of `max_deviation`. Null where
    /// rounding hides it.
    pub slope: Option<f64>,
    /// Where the formula holds at these values, in words and numbers.
    pub ranges: Vec<Range>,
    /// Values that the method left open: hbar as it was chosen, the coefficients of a balance as
    /// they were solved for.
    pub chosen: Map<f64>,
    /// The value of every symbol of the formulas: parameters, amplitude (1 where the equation is
    /// linear and none was given), definitions, what was chosen, `omega` and `pi`. Laws that are
    /// written for the size of the amplitude have its size here. A symbol that has no real value is
    /// left out.
    #[serde(default)]
    pub values: Map<f64>,
    /// theta at t = 0, in radians: theta = omega t + phase. It is pi for a negative amplitude whose
    /// size stands in `values`, else 0.
    #[serde(default)]
    pub phase: f64,
    /// The motion in numbers, whatever the method: x = sum of cos * cos(harmonic theta) + sin *
    /// sin(harmonic theta), the equilibrium in harmonic 0; harmonics below 1e-14 of the largest are
    /// left out. Where phase is pi and the force is not odd, only this starts at the amplitude, not
    /// `displacement`. Null where the frequency is not real or the motion is not known.
    #[serde(default)]
    pub motion: Option<Vec<HarmonicValue>>,
    /// The steady motions of a driven equation, largest first; empty for any other.
    #[serde(default)]
    pub steady_states: Vec<SteadyState>,
    /// How many steady motions of the truncated slow equations have no true motion near by, at
    /// amplitudes at which the last order is more than half of the one before it. Left out where
    /// there are none.
    #[serde(default, skip_serializing_if = "is_nothing")]
    pub spurious: usize,
    /// What else is known of a motion that is not periodic; null for any other.
    #[serde(default)]
    pub followed: Option<Followed>,
    /// Whether |relative_error| is within the tolerance, 0.01 unless another was given.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [verify::Verdict::Pass.name(), verify::Verdict::Fail.name()])))]
    pub verdict: String,
}

/// A steady motion in numbers, by the slow equations and in truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct SteadyState {
    /// The amplitude by the slow equations, in the unit of the coordinate.
    pub amplitude: f64,
    /// The phase by the slow equations, from -pi to pi, in radians.
    pub phase: f64,
    /// Real and imaginary part of each eigenvalue of the slow equations, per unit of time.
    pub eigenvalues: [[f64; 2]; 2],
    /// Whether both real parts are negative.
    pub stable: bool,
    /// The amplitude of the true periodic motion near it; null where none was found.
    pub true_amplitude: Option<f64>,
    /// Whether the true motion attracts, by its Floquet multipliers; null where none was found.
    pub true_stable: Option<bool>,
    /// amplitude / true_amplitude - 1, as a fraction; null for a motion without a part of its own.
    pub relative_error: Option<f64>,
    /// The largest |x - x_true| over one period, as a fraction of the largest |x_true|; null where
    /// no true motion was found.
    pub max_deviation: Option<f64>,
}

/// One harmonic of a motion in numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct HarmonicValue {
    /// The multiple of theta, 0 for the mean.
    pub harmonic: usize,
    /// The coefficient of the cosine, in the unit of the coordinate.
    pub cos: f64,
    /// The coefficient of the sine, in the unit of the coordinate.
    pub sin: f64,
}

/// The verdict on a formula.
///
/// ```
/// use lindstedt::{Options, Oscillator, judge, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// let judged = judge(&duffing, &solution, &"A = 1, eps = 1/10".parse()?, 0.01)?;
/// let document = lindstedt::export::json::verification::verification(&judged);
/// assert_eq!(document.true_frequency, judged.true_frequency);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn verification(verification: &verify::Verification) -> Verification {
    Verification {
        at: constants(&verification.at),
        frequency: finite(verification.frequency),
        reason: text(verification.reason.as_ref()),
        true_frequency: verification.true_frequency,
        relative_error: finite(verification.relative_error),
        judged_on: verification.judged_on.to_owned(),
        error_of_omega: finite(verification.error_of_omega),
        max_deviation: finite(verification.max_deviation),
        no_deviation: verification.no_deviation.clone(),
        residual: finite(verification.residual),
        slope: finite(verification.slope),
        ranges: verification.ranges.clone(),
        chosen: named(verification.chosen.iter().copied()),
        values: named(verification.values.iter().copied()),
        phase: verification.phase,
        motion: verification.motion.as_ref().and_then(motion),
        steady_states: verification.steady_states.iter().map(steady_state).collect(),
        spurious: verification.spurious,
        followed: verification.followed.clone(),
        verdict: verification.verdict.name().to_owned(),
    }
}

/// A steady motion in numbers.
fn steady_state(judged: &verify::JudgedState) -> SteadyState {
    SteadyState {
        amplitude: judged.state.amplitude,
        phase: judged.state.phase,
        eigenvalues: judged.state.eigenvalues.map(|(real, imaginary)| [real, imaginary]),
        stable: judged.state.is_stable(),
        true_amplitude: finite(judged.true_amplitude),
        true_stable: judged.true_stable,
        relative_error: finite(judged.relative_error),
        max_deviation: finite(judged.max_deviation),
    }
}

/// The harmonics of a motion in numbers but for rounding noise; nothing where one of them is not
/// finite.
fn motion(motion: &FourierSeries<Doubles>) -> Option<Vec<HarmonicValue>> {
    let entry = |harmonic: usize| HarmonicValue {
        harmonic,
        cos: motion.cosine(harmonic).mean().0,
        sin: motion.sine(harmonic).mean().0,
    };
    let size = |entry: &HarmonicValue| entry.cos.hypot(entry.sin);
    let entries: Vec<HarmonicValue> = (0..=motion.highest_harmonic()).map(entry).collect();
    let noise = rounding_noise(motion);
    entries
        .into_iter()
        .filter(|entry| size(entry) > noise || !size(entry).is_finite())
        .map(|entry| size(&entry).is_finite().then_some(entry))
        .collect()
}

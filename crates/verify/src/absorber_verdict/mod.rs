//! The formulas of absorbers beside searches, quadratures and simulations.
//!
//! In: the formulas of a kind of absorber, and values of its letters. Out: each formula in numbers
//! beside the truth, and the curves of a picture.
//!
//! - `tuned`: the frequency response of the two masses, searched for its lowest peak and variance.
//! - `nonlinear`: both peaks of the response of the two equations, and the cubic spring that makes them
//!   equally high.
//! - `impact_sink`: the two masses from impact to impact, a ball in its cavity or a pendulum between barriers.
//! - `cubic_sink`: periodic motions of the sink by Runge-Kutta, and the two masses set free.

mod cubic_sink;
mod impact_sink;
mod nonlinear;
mod tuned;

use crate::absorber::{AbsorberError, AbsorberKind, AbsorberLaws};
use crate::symbol::Symbol;
use crate::values::Values;
use crate::verify::Verdict;

/// The formulas of an absorber at values of its letters, judged.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct JudgedAbsorber {
    /// The values.
    pub at: Values,
    /// The relative error up to which a formula passes.
    pub tolerance: f64,
    /// The formulas, design by design.
    pub formulas: Vec<JudgedAbsorberFormula>,
    /// The lowest peak by a search; `None` if it has a formula, or has no meaning, and where doubles do
    /// not resolve the peaks.
    pub lowest_peak: Option<LowestPeak>,
    /// A simulated motion of a sink; `None` for a tuned or nonlinear absorber, and where it leaves the
    /// manifold at once.
    pub motion: Option<AbsorberMotion>,
    /// The amplitudes at which the body of an impact sink touches a wall between its impacts, so that its
    /// motion ends there before it is unstable; `None` if it does not.
    pub touch: Option<AbsorberTouch>,
    /// The curves of a picture: of responses over frequency, or of motions over amplitude.
    pub curves: Vec<AbsorberCurve>,
    /// Whether the formulas are within the tolerance, those aside that another design has to the next
    /// order; `None` where those that have a truth are, and some have none.
    pub verdict: Option<Verdict>,
}

/// A formula of a design in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedAbsorberFormula {
    /// The name of the design.
    pub design: &'static str,
    /// The name of the quantity.
    pub name: &'static str,
    /// The symbol of the quantity.
    pub symbol: Symbol,
    /// Its value by the formula; `None` where there is no such design, as an amplitude that is not positive.
    pub value: Option<f64>,
    /// The true value; `None` where none was found.
    pub truth: Option<f64>,
    /// `value/truth - 1`.
    pub relative_error: Option<f64>,
}

/// The tuned mass damper with which the highest amplitude at any frequency is the least (H-infinity).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowestPeak {
    /// The natural frequency of the absorber alone over that of the main mass alone, f.
    pub tuning: f64,
    /// The damping ratio of the absorber alone, zeta.
    pub damping: f64,
    /// The highest amplitude over the static one, h.
    pub height: f64,
}

/// A simulated motion that follows the manifold of a sink.
#[derive(Clone, Debug, PartialEq)]
pub struct AbsorberMotion {
    /// What is simulated.
    pub words: &'static str,
    /// The amplitude of the main mass at the start.
    pub start: f64,
    /// The amplitude of the main mass where the motion leaves the manifold.
    pub end: f64,
    /// The largest distance of its two amplitudes from those on the manifold, over those of the
    /// start.
    pub largest_distance: f64,
    /// The time that it takes, where there is a formula of it.
    pub decay: Option<AbsorberDecay>,
}

/// The motion with two impacts a period at which the body touches a wall between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AbsorberTouch {
    /// The amplitude of the main mass.
    pub amplitude: f64,
    /// The amplitude of the sink.
    pub sink: f64,
}

/// The time in which the amplitude of the main mass falls, on a simulated motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AbsorberDecay {
    /// The amplitudes of the main mass at the start and at the end.
    pub amplitudes: [f64; 2],
    /// The time by the formula, in units of 1/(the frequency of the main mass).
    pub formula: f64,
    /// The time of the simulated motion.
    pub truth: f64,
}

impl AbsorberMotion {
    /// The motion through these amplitudes of main mass and sink beside points of a manifold; `None`
    /// if there is none.
    fn along(manifold: &[(f64, f64)], motion: &[(f64, f64)], words: &'static str) -> Option<Self> {
        let [first, .., last] = motion else { return None };
        let size = first.0.hypot(first.1);
        let distance = |point: &(f64, f64)| {
            let each = manifold.iter().map(|own| (own.0 - point.0).hypot(own.1 - point.1));
            each.fold(f64::INFINITY, f64::min) / size
        };
        let largest_distance = motion.iter().map(distance).fold(0.0, f64::max);
        Some(Self { words, start: first.0, end: last.0, largest_distance, decay: None })
    }
}

/// A curve of the picture of an absorber.
#[derive(Clone, Debug, PartialEq)]
pub struct AbsorberCurve {
    /// What it is, in words.
    pub label: String,
    /// How it came about.
    pub kind: AbsorberCurveKind,
    /// Its points.
    pub points: Vec<(f64, f64)>,
}

/// How a curve came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AbsorberCurveKind {
    /// A true response with the values of a design, or a true motion.
    Truth,
    /// The same with other values, for comparison.
    Background,
    /// A formula.
    Formula,
    /// A part of a formula that is an unstable motion.
    Unstable,
    /// Single points by formulas.
    Points,
}

impl AbsorberCurveKind {
    /// The name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::Truth => "truth",
            Self::Background => "background",
            Self::Formula => "formula",
            Self::Unstable => "unstable",
            Self::Points => "points",
        }
    }
}

/// True values by design and quantity, and the curves.
#[derive(Default)]
struct Truth {
    values: Vec<(&'static str, &'static str, Option<f64>)>,
    curves: Vec<AbsorberCurve>,
    lowest_peak: Option<LowestPeak>,
    motion: Option<AbsorberMotion>,
    touch: Option<AbsorberTouch>,
    /// The name of a design that there is not at these values.
    absent: Option<&'static str>,
}

/// Judges the formulas of an absorber at values of its letters.
///
/// # Errors
/// [`AbsorberError`] for values that are missing, unknown or outside their range.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::absorber::{AbsorberKind, Excitation, derive};
/// use lindstedt::absorber_verdict::judge_absorber;
/// use lindstedt::verify::Verdict;
///
/// let laws = derive(AbsorberKind::Tuned(Excitation::Force))?;
/// let judged = judge_absorber(&laws, &"mu = 1/20".parse()?, 0.01)?;
/// let height = judged.formulas.iter().find(|own| own.name == "height").ok_or("no height")?;
/// assert!(height.truth.is_some_and(|truth| (truth - 6.403124).abs() < 1e-6));
/// assert_eq!(judged.verdict, Some(Verdict::Pass));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn judge_absorber(
    laws: &AbsorberLaws,
    at: &Values,
    tolerance: f64,
) -> Result<JudgedAbsorber, AbsorberError> {
    laws.check(at)?;
    let truth = match laws.kind {
        AbsorberKind::Tuned(excitation) | AbsorberKind::Damped(excitation) => {
            tuned::truth(laws, excitation, at)
        }
        AbsorberKind::Nonlinear => nonlinear::truth(laws, at),
        AbsorberKind::ImpactSink | AbsorberKind::PendulumSink => impact_sink::truth(laws, at),
        AbsorberKind::CubicSink => cubic_sink::truth(laws, at),
    };
    let mut formulas = Vec::new();
    for design in &laws.designs {
        for own in &design.formulas {
            // Amplitudes, ratios and dampings are positive: a formula that is not says that there is none.
            let is_absent = truth.absent == Some(design.name);
            let value = laws.value(&own.formula, at).filter(|value| *value > 0.0 && !is_absent);
            let known = truth.values.iter().find(|row| (row.0, row.1) == (design.name, own.name));
            let known = known.and_then(|row| row.2).filter(|truth| truth.is_finite());
            let relative_error = value.zip(known).map(|(value, truth)| value / truth - 1.0);
            formulas.push(JudgedAbsorberFormula {
                design: design.name,
                name: own.name,
                symbol: own.symbol,
                value,
                truth: known,
                relative_error: relative_error.filter(|error| error.is_finite()),
            });
        }
    }
    let is_refined =
        |name: &str| laws.design(name).is_some_and(|design| design.refined_by.is_some());
    let judged = || formulas.iter().filter(|own| !is_refined(own.design));
    let is_off = |own: &JudgedAbsorberFormula| {
        own.truth.is_some() && own.relative_error.is_none_or(|error| error.abs() > tolerance)
    };
    let is_known = |own: &JudgedAbsorberFormula| own.truth.is_some() || own.value.is_none();
    let verdict = match (judged().any(is_off), judged().all(is_known)) {
        (true, _) => Some(Verdict::Fail),
        (false, true) => Some(Verdict::Pass),
        (false, false) => None,
    };
    let curves = truth.curves.into_iter().filter(|curve| !curve.points.is_empty()).collect();
    Ok(JudgedAbsorber {
        at: at.clone(),
        tolerance,
        formulas,
        lowest_peak: truth.lowest_peak,
        motion: truth.motion,
        touch: truth.touch,
        curves,
        verdict,
    })
}

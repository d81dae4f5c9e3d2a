//! Comparison of all methods for one equation with its true motion.
//!
//! In: an equation, numbers for its symbols, a tolerance. Out: a [`Comparison`], a row for each
//! method that applies and a reason for each that does not; from it omega against the amplitude, a
//! [`Backbone`] a method.

use std::collections::BTreeMap;

use super::backbone::TrueBackbone;
use super::formula::{formula_frequency_along, numbers_or_reason};
use super::orbit::TrueMotion;
use super::reach::amplitude_reach;
use super::validity::{self, AmplitudeReach};
use super::values::checked_numbers;
use super::{Verdict, VerificationError, judge, largest_deviation, orbit_target};
use crate::decimal::{decimal, significant};
use crate::expr::Equation;
use crate::method::homotopy_analysis::convergence_control;
use crate::method::numbers::{NoNumbers, NumbersCache};
use crate::method::{Options, Reason, Refusal, solve, with_resonance_at};
use crate::oscillator::{Oscillator, OscillatorError, SmallParameter};
use crate::solution::{AmplitudeConvention, Method, Solution};
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FIRST_HARMONIC, ResultSymbols};
use crate::values::Values;

/// A method that applies.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ComparisonRow {
    /// The derived answer.
    pub solution: Solution,
    /// omega by the formula; `None` if there is none.
    pub frequency: Option<f64>,
    /// The reason why there is no frequency.
    pub reason: Option<NoNumbers>,
    /// Values that the formula leaves open: the chosen hbar, or the solved coefficients of a
    /// balance.
    pub chosen: Vec<(Symbol, f64)>,
    /// `frequency / true_frequency - 1`.
    pub relative_error: Option<f64>,
    /// Largest deviation of the motion over one true period, over the amplitude.
    pub max_deviation: Option<f64>,
    /// The range in which the frequency is within the tolerance, of the amplitude of the table's
    /// first row.
    pub reach: Option<AmplitudeReach>,
    /// The verdict on the frequency; `None` if the true one is not known.
    pub verdict: Option<Verdict>,
}

impl ComparisonRow {
    /// The convergence-control parameter and its chosen value; `None` if the row has none.
    pub fn chosen_hbar(&self) -> Option<(Symbol, f64)> {
        let hbar = convergence_control(&self.solution);
        let own = self.chosen.iter().filter(|_| self.solution.method == Method::HomotopyAnalysis);
        own.copied().find(|entry| entry.0 == hbar)
    }
}

impl Comparison {
    /// The symbols of amplitude and frequency in its formulas, those of the first answer.
    pub fn letters(&self) -> ResultSymbols {
        let first = self.rows.first().map(|row| row.solution.letters());
        first.unwrap_or_else(|| ResultSymbols::avoiding(&[], false))
    }
}

/// A method that does not apply.
#[derive(Clone, Debug, PartialEq)]
pub struct Refused {
    /// The method.
    pub method: Method,
    /// The reason.
    pub reason: Refusal,
}

/// The table.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Comparison {
    /// The equation as it was understood.
    pub equation: Equation,
    /// The values at which the methods were judged.
    pub at: Values,
    /// omega of the true motion; `None` if it cannot be computed.
    pub true_frequency: Option<f64>,
    /// The reason why it cannot be computed.
    pub reason: Option<VerificationError>,
    /// The tolerance of verdicts and ranges, relative: 0.01 is 1 %.
    pub tolerance: f64,
    /// The methods that apply, in the order of [`Method::ALL`].
    pub rows: Vec<ComparisonRow>,
    /// The methods that do not apply.
    pub refused: Vec<Refused>,
    /// The ranges of validity, in words, if the true motion is periodic.
    pub validity: Vec<String>,
}

/// The variants of each method that are compared: the defaults, both orders of averaging, the three
/// of driven multiple scales and, for homotopy perturbation, the first order as well.
fn variants(oscillator: &Oscillator, small: Option<&str>) -> Vec<Options> {
    let parts = oscillator.parts().ok();
    let driven = parts.as_ref().is_some_and(|parts| !parts.forcing.is_zero());
    let conserves = !driven && parts.is_some_and(|parts| parts.damping.is_zero());
    let default = |method| Options {
        method: Some(method),
        small: small.map(str::to_owned),
        // Without damping every row uses the same amplitude.
        amplitude: (method == Method::Averaging && conserves)
            .then_some(AmplitudeConvention::Initial),
        ..Options::default()
    };
    let mut variants = Vec::new();
    for method in Method::ALL {
        variants.push(default(method));
        if method == Method::HomotopyPerturbation {
            variants.push(Options { order: Some(1), ..default(method) });
        }
        let higher: &[u32] = match method {
            Method::Averaging => &[2],
            Method::MultipleScales if driven => &[2, 3],
            _ => &[],
        };
        variants
            .extend(higher.iter().map(|order| Options { order: Some(*order), ..default(method) }));
    }
    variants
}

/// Judges every method on `oscillator` at the values `at`.
///
/// # Errors
/// No method applies; values are missing or unknown; no periodic motion there.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::{Method, Oscillator, verify::comparison::compare};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let table = compare(&pendulum, &"A = 1".parse()?, None, 0.01)?;
/// let exact = table.rows.iter().find(|row| row.solution.method == Method::Exact);
/// assert!(exact.and_then(|row| row.relative_error).is_some_and(|error| error.abs() < 1e-12));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare(
    oscillator: &Oscillator,
    at: &Values,
    small: Option<&str>,
    tolerance: f64,
) -> Result<Comparison, VerificationError> {
    let _letters = oscillator.letters().in_force();
    // A force too long to be expanded stops every method with the same error, which is reported
    // once.
    if let Err(error) = oscillator.parts() {
        let reason = Refusal::from(error);
        let refused = Method::ALL.map(|method| Refused { method, reason: reason.clone() });
        return Err(VerificationError::NoMethod(refused.into()));
    }
    let (solutions, slow, mut refused) = answers(oscillator, at, small);
    let Some(first) = solutions.first() else {
        return match slow.is_empty() {
            true => Err(VerificationError::NoMethod(refused)),
            false => of_transients(oscillator, slow, refused, at, tolerance),
        };
    };
    if first.response.is_some() {
        return driven(oscillator, at, tolerance, &solutions, refused);
    }
    if let Some(solution) = slow.first() {
        refused.push(Refused {
            method: solution.method,
            reason: Reason::NoSteadyAmplitude.to(solution.method),
        });
    }
    super::periodic(first)?;
    // Every row is about the motion that starts at A, whatever the amplitude in its formula means.
    let at_first = by_start(first, at);
    let numbers = checked_numbers(first, &at_first)?;
    super::check_digits(oscillator, first, &numbers)?;
    let meant = orbit_target(oscillator, first, &numbers);
    let (true_motion, reason) = match super::meant_motion(oscillator, first, &meant, &numbers) {
        Ok(motion) => (Some(motion), None),
        Err(error) if error.leaves_the_truth_open() => (None, Some(error)),
        Err(error) => return Err(error),
    };
    let at_amplitude = validity::backbone(oscillator, first, &numbers);
    let rows = solutions
        .iter()
        .map(|solution| {
            row(oscillator, solution, &numbers, true_motion.as_ref(), &at_amplitude, tolerance)
        })
        .collect();
    let validity = validity::of_equation(oscillator, first, &numbers);
    Ok(Comparison {
        equation: first.equation.clone(),
        at: at.clone(),
        true_frequency: true_motion.map(|motion| motion.frequency),
        reason,
        tolerance,
        rows,
        refused,
        validity: validity.into_iter().map(|range| range.text).collect(),
    })
}

/// Answers of all methods: periodic motions, transients that do not settle, and the refusals of the
/// other methods.
fn answers(
    oscillator: &Oscillator,
    at: &Values,
    small: Option<&str>,
) -> (Vec<Solution>, Vec<Solution>, Vec<Refused>) {
    let (mut solutions, mut slow, mut refused) = (Vec::new(), Vec::new(), Vec::new());
    let in_a_parameter = small.is_none()
        && !matches!(oscillator.small_parameter(None), Ok(SmallParameter::Amplitude));
    for options in variants(oscillator, small) {
        let solved = |options: &Options| {
            with_resonance_at(oscillator, options, at)
                .and_then(|options| solve(oscillator, &options))
        };
        let mut found = solved(&options);
        if found.is_err() && in_a_parameter {
            // If the default small parameter does not suit a method, the amplitude may.
            let by_amplitude = solved(&Options {
                small: Some(AmplitudeConvention::Initial.symbol().to_string()),
                ..options.clone()
            });
            let about_small = matches!(
                &found,
                Err(Refusal {
                    reason: Reason::Oscillator(
                        OscillatorError::NotSmall { .. }
                            | OscillatorError::NotPolynomial(_)
                            | OscillatorError::AmbiguousSmallParameter(_)
                    ),
                    ..
                })
            );
            if by_amplitude.is_ok() || about_small {
                found = by_amplitude;
            }
        }
        match (found, options.method) {
            // Slow equations are compared by the periodic motion on which they settle.
            (Ok(solution), _) if solution.slow().is_some() => match solution.on_cycle() {
                Some(settled) => solutions.push(settled),
                None => slow.push(solution),
            },
            // A motion without a known initial state cannot be compared.
            (Ok(solution), Some(method))
                if solution.response.is_none() && super::periodic(&solution).is_err() =>
            {
                refused.push(Refused { method, reason: Reason::NoSteadyAmplitude.to(method) })
            }
            (Ok(solution), _) => solutions.push(solution),
            (Err(reason), Some(method))
                if refused.iter().all(|known: &Refused| known.method != method) =>
            {
                refused.push(Refused { method, reason });
            }
            (Err(_), _) => {}
        }
    }
    let applies = |method: Method| {
        solutions.iter().chain(&slow).any(|solution: &Solution| solution.method == method)
    };
    refused.retain(|refused: &Refused| !applies(refused.method));
    solutions.dedup_by(|second, first| {
        second.method == first.method && second.formula() == first.formula()
    });
    (solutions, slow, refused)
}

/// The values with `A` used as the amplitude of the first harmonic, to which it is equal to leading
/// order, if no method uses `A` itself.
fn by_start(first: &Solution, at: &Values) -> Values {
    let [initial, own] =
        [AmplitudeConvention::Initial, first.amplitude].map(AmplitudeConvention::symbol);
    let free = initial != own && first.limit_cycle.is_none() && at.get(own).is_none();
    if !free || at.get(initial).is_none() {
        return at.clone();
    }
    let renamed = at.iter().map(|(name, value)| (if name == initial { own } else { name }, value));
    let mut values = Values::default();
    for (name, value) in renamed {
        if values.insert(name, value.clone()).is_err() {
            return at.clone();
        }
    }
    values
}

/// The methods for driven motions, judged by the amplitude of their largest stable steady motion.
fn driven(
    oscillator: &Oscillator,
    at: &Values,
    tolerance: f64,
    solutions: &[Solution],
    refused: Vec<Refused>,
) -> Result<Comparison, VerificationError> {
    let (mut rows, mut validity, mut frequency) = (Vec::new(), Vec::new(), None);
    for solution in solutions {
        let judged = super::judge(oscillator, solution, at, tolerance)?;
        frequency = frequency.or(judged.frequency);
        let largest = judged.steady_states.iter().find(|judged| judged.state.is_stable());
        let words = match largest.map(|judged| (judged.state.amplitude, judged.true_amplitude)) {
            Some((own, Some(truth))) => format!(
                "{FIRST_HARMONIC} = {} against a true {}",
                significant(own, 6),
                significant(truth, 6)
            ),
            Some((own, None)) => {
                format!("{FIRST_HARMONIC} = {}, and no true motion near it", significant(own, 6))
            }
            None => "no stable steady motion".to_owned(),
        };
        validity.push(format!(
            "driven: the error is that of the amplitude; {}: {words}",
            solution.title()
        ));
        rows.push(ComparisonRow {
            solution: solution.clone(),
            frequency: judged.frequency,
            reason: None,
            chosen: vec![],
            relative_error: judged.relative_error,
            max_deviation: judged.max_deviation,
            reach: None,
            verdict: Some(judged.verdict),
        });
    }
    let equation = solutions.first().map(|first| first.equation.clone());
    Ok(Comparison {
        equation: equation.unwrap_or_else(|| oscillator.equation()),
        at: at.clone(),
        true_frequency: frequency,
        reason: None,
        tolerance,
        rows,
        refused,
        validity,
    })
}

/// The table of a motion that is not periodic, followed from its start.
fn of_transients(
    oscillator: &Oscillator,
    slow: Vec<Solution>,
    refused: Vec<Refused>,
    at: &Values,
    tolerance: f64,
) -> Result<Comparison, VerificationError> {
    let (mut rows, mut truth, mut reason, mut validity) = (vec![], None, None, vec![]);
    for solution in slow {
        let judged = match judge(oscillator, &solution, at, tolerance) {
            Ok(judged) => judged,
            Err(error) if error.leaves_the_truth_open() => {
                reason = Some(error);
                continue;
            }
            Err(error) => return Err(error),
        };
        truth = truth.or(Some(judged.true_frequency));
        if let (Some(followed), true) = (&judged.followed, validity.is_empty()) {
            validity.push(format!(
                "released at rest from {AMPLITUDE} and followed to t = {}: {}; its frequency is pi over the mean time between its \
                 passages through the equilibrium",
                decimal(followed.until),
                followed.reason
            ));
        }
        rows.push(ComparisonRow {
            frequency: judged.frequency,
            reason: judged.reason,
            chosen: judged.chosen,
            relative_error: judged.relative_error,
            max_deviation: judged.max_deviation,
            reach: None,
            verdict: Some(judged.verdict),
            solution,
        });
    }
    match rows.first() {
        Some(first) => Ok(Comparison {
            equation: first.solution.equation.clone(),
            at: at.clone(),
            true_frequency: truth,
            reason,
            tolerance,
            rows,
            refused,
            validity,
        }),
        None => Err(reason.unwrap_or(VerificationError::NoMethod(refused))),
    }
}

fn row(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    true_motion: Option<&TrueMotion>,
    truth: &TrueBackbone,
    tolerance: f64,
) -> ComparisonRow {
    let (found, reason) = numbers_or_reason(oscillator, solution, numbers);
    let frequency = found.as_ref().map(|found| found.frequency_squared.sqrt());
    let relative_error =
        frequency.zip(true_motion).map(|(frequency, truth)| frequency / truth.frequency - 1.0);
    let max_deviation = frequency
        .zip(found.as_ref().and_then(|found| found.motion.as_ref()))
        .zip(true_motion)
        .and_then(|((frequency, motion), truth)| largest_deviation(truth, frequency, motion));
    let pass = relative_error.is_some_and(|error| error.abs() <= tolerance);
    ComparisonRow {
        solution: solution.clone(),
        frequency,
        reason,
        chosen: found.map_or_else(Vec::new, |found| found.chosen),
        relative_error,
        max_deviation,
        reach: amplitude_reach(oscillator, solution, truth, tolerance),
        verdict: true_motion.map(|_| Verdict::from_passed(pass)),
    }
}

/// A curve of omega against the amplitude.
#[derive(Clone, Debug, PartialEq)]
pub struct Backbone {
    /// The methods that share it.
    pub methods: Vec<String>,
    /// Amplitude and frequency.
    pub points: Vec<(f64, f64)>,
}

/// omega against the amplitude: the truth, and every method of the table; methods with the same
/// curve share one.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::{Oscillator, verify::comparison::{backbones, compare}};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let table = compare(&pendulum, &"A = 1".parse()?, None, 0.01)?;
/// let (truth, curves) = backbones(&pendulum, &table)?;
/// assert!(!truth.points.is_empty() && !curves.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn backbones(
    oscillator: &Oscillator,
    comparison: &Comparison,
) -> Result<(Backbone, Vec<Backbone>), VerificationError> {
    const POINTS: usize = 120;
    let no_method = || VerificationError::NoMethod(comparison.refused.clone());
    let first = &comparison.rows.first().ok_or_else(no_method)?.solution;
    let missing = if first.slow().is_some() {
        Some("that of this motion changes; `derive --plot` draws it with its envelope")
    } else if first.response.is_some() {
        Some(
            "this motion has the frequency of the drive; `response --plot` draws its amplitude against that",
        )
    } else if first.limit_cycle.is_some() {
        Some("a limit cycle has one; `derive --plot` draws the motion")
    } else {
        None
    };
    if let Some(reason) = missing {
        return Err(VerificationError::NoBackbone(reason));
    }
    let numbers = checked_numbers(first, &by_start(first, &comparison.at))?;
    let truth = validity::backbone(oscillator, first, &numbers);
    let asked = numbers.get(&first.amplitude.symbol()).map_or(1.0, |value| value.abs());
    // The curves extend to the escape, or to twice the amplitude asked for.
    let last = f64::min(truth.largest_amplitude() * 0.995, 2.0 * asked);
    // Motions over several wells begin at the separatrix.
    let inner = truth.smallest_amplitude();
    let amplitudes: Vec<f64> =
        (1..=POINTS).map(|k| inner + (last - inner) * k as f64 / POINTS as f64).collect();
    let curve = |of: &dyn Fn(f64) -> Option<f64>| -> Vec<(f64, f64)> {
        // A formula may have real frequencies only at larger amplitudes.
        let without = amplitudes
            .iter()
            .take_while(|&&amplitude| inner > 0.0 && of(amplitude).is_none())
            .count();
        amplitudes[without..]
            .iter()
            .map_while(|&amplitude| Some((amplitude, of(amplitude)?)))
            .collect()
    };
    let true_curve = Backbone {
        methods: vec!["true motion".to_owned()],
        points: curve(&|amplitude| truth.frequency(amplitude)),
    };
    let mut curves: Vec<Backbone> = Vec::new();
    for row in comparison.rows.iter().filter(|row| row.solution.method != Method::Exact) {
        let followed = NumbersCache::default();
        let points = curve(&|amplitude| {
            formula_frequency_along(
                oscillator,
                &row.solution,
                &truth.numbers_at(amplitude),
                &followed,
            )
        });
        let same = |known: &&mut Backbone| {
            known.points.len() == points.len()
                && known
                    .points
                    .iter()
                    .zip(&points)
                    .all(|(a, b)| (a.1 - b.1).abs() <= 1e-9 * b.1.abs())
        };
        match curves.iter_mut().find(same) {
            Some(known) => known.methods.push(row.solution.title()),
            None => curves.push(Backbone { methods: vec![row.solution.title()], points }),
        }
    }
    Ok((true_curve, curves))
}

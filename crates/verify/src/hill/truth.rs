//! Verification of transition curves by Floquet's multipliers of the equation as it was typed.
//!
//! References: Nayfeh and Mook, section 5.2 (Floquet), 5.3 (Hill's determinant).
//!
//! ```text
//! det(-(D^2 + c D + k) - mu) = 0            mu from Hill's determinant, in numbers, with many harmonics
//! Phi(T) of x'' + c x' + (k + mu) x = 0     has the multiplier +1 (n even) or -1 (n odd)
//! ```
//!
//! The determinant assigns roots to tongues, because real ones come in their order; the multiplier
//! of the integrated motion confirms it. Only the number of the curve is taken from the derivation.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::{DMatrix, Schur, SymmetricEigen};

use super::{HillError, TransitionCurve, TransitionCurves, Unknown, WavesOfMotion};
use crate::expr::{CompiledFunction, Expr};
use crate::numeric::ode::root::find_root;
use crate::symbol::Symbol;
use crate::system::{System, SystemOptions};
use crate::values::Values;

/// Number of harmonics beyond those that the coefficients require.
const SPARE_HARMONICS: usize = 16;

/// Highest harmonic of the motion, in multiples of the highest harmonic of the coefficients.
const TIMES_TAKEN_ON: usize = 3;

/// Largest number of harmonics of the determinant.
pub(super) const MOST_HARMONICS: usize = 200;

/// Rounding error of a value of the determinant, over the square of the frequency.
const ROUNDING: f64 = 1e-12;

/// Largest residual of the characteristic equation `1 -+ tr Phi + det Phi = 0` at a multiplier,
/// over the size of its terms.
const MULTIPLIER_TOLERANCE: f64 = 1e-6;

/// The imaginary part up to which an eigenvalue counts as real, over the size of the matrix.
const REAL: f64 = 1e-10;

/// A curve at given values.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedCurve {
    /// Index of the curve.
    pub curve: usize,
    /// The value by the formula; `None` if it is not real.
    pub value: Option<f64>,
    /// The true value; `None` if the tongue does not reach so far.
    pub truth: Option<f64>,
    /// `value/truth - 1`; `None` if either is `None`, or if only the truth is zero.
    pub relative_error: Option<f64>,
    /// Whether the formula is within the tolerance; it is if neither value exists.
    pub passes: bool,
}

/// Formula and truth of a curve against a small parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Index of the curve.
    pub curve: usize,
    /// `(unknown, small parameter)` by the formula.
    pub formula: Vec<(f64, f64)>,
    /// `(unknown, small parameter)` of the true curve.
    pub truth: Vec<(f64, f64)>,
}

/// Every curve at the values, compared with the truth.
///
/// # Errors
/// [`HillError`].
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::Oscillator;
/// use lindstedt::hill::{HillOptions, judge, transition_curves};
///
/// let mathieu = Oscillator::parse("x'' + (delta + eps*cos(2*t))*x = 0")?;
/// let curves = transition_curves(&mathieu, &HillOptions::default())?;
/// let judged = judge(&curves, &"eps = 2/5".parse()?, 1e-3)?;
/// // a_1 and b_1 of Mathieu's equation in the form of Abramowitz and Stegun, q = eps/2.
/// assert!(judged.iter().all(|curve| curve.passes));
/// assert!((judged[1].truth.ok_or("a root")? - 0.795_124).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn judge(
    curves: &TransitionCurves,
    at: &Values,
    tolerance: f64,
) -> Result<Vec<JudgedCurve>, HillError> {
    let numbers = at.numbers();
    let unknown = curves.unknown.symbol();
    for name in numbers.keys() {
        if *name == unknown {
            return Err(HillError::Unknown(*name, "the curves give"));
        }
        if !curves.parameters.contains(name) {
            return Err(HillError::Unknown(*name, "does not occur"));
        }
    }
    let missing = |name: &&Symbol| **name != unknown && !numbers.contains_key(*name);
    let missing: Vec<String> =
        curves.parameters.iter().filter(missing).map(|name| format!("`{name}`")).collect();
    if !missing.is_empty() {
        return Err(HillError::Missing(missing.join(", ")));
    }
    let one = |(index, curve): (usize, &TransitionCurve)| {
        let value = formula(curves, curve, &numbers);
        let truth = true_value(curves, curve, &numbers)?;
        let relative_error = match (value, truth) {
            (Some(value), Some(truth)) if value == truth => Some(0.0),
            (Some(value), Some(truth)) if truth != 0.0 => Some((value - truth) / truth.abs()),
            _ => None,
        };
        let passes = match (value, truth) {
            (Some(value), Some(truth)) => (value - truth).abs() <= tolerance * truth.abs(),
            (None, None) => true,
            _ => false,
        };
        Ok(JudgedCurve { curve: index, value, truth, relative_error, passes })
    };
    curves.curves.iter().enumerate().map(one).collect()
}

/// Every curve for values of the small parameter `by` from zero to `upto`, in equal steps.
///
/// # Errors
/// [`HillError`].
pub fn chart(
    curves: &TransitionCurves,
    at: &BTreeMap<Symbol, f64>,
    by: Symbol,
    upto: f64,
    steps: u32,
) -> Result<Vec<Chart>, HillError> {
    let mut charts = Vec::new();
    for (index, curve) in curves.curves.iter().enumerate() {
        let (mut formulas, mut truths) = (Vec::new(), Vec::new());
        for step in 0..=steps {
            let size = upto * f64::from(step) / f64::from(steps);
            let mut numbers = at.clone();
            numbers.insert(by, size);
            formulas.extend(formula(curves, curve, &numbers).map(|value| (value, size)));
            truths.extend(true_value(curves, curve, &numbers)?.map(|value| (value, size)));
        }
        charts.push(Chart { curve: index, formula: formulas, truth: truths });
    }
    Ok(charts)
}

/// The value that the formula gives: of the frequency, not of its square.
fn formula(
    curves: &TransitionCurves,
    curve: &TransitionCurve,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<f64> {
    let value_of = |name: Symbol| match name.name() {
        "pi" => Some(std::f64::consts::PI),
        _ => numbers.get(&name).copied(),
    };
    let middle = curve.middle.evaluate(value_of).ok()?;
    let root = match &curve.under_root {
        None => 0.0,
        Some(root) => root.evaluate(value_of).ok()?.sqrt(),
    };
    let value = if curve.upper { middle + root } else { middle - root };
    letter_of_power(value, curves.unknown.power()).filter(|value| value.is_finite())
}

/// The value of the symbol whose power is given, the positive one of two; `None` if it is not real.
fn letter_of_power(value: f64, power: i32) -> Option<f64> {
    match power {
        1 => Some(value),
        2 => Some(value.sqrt()),
        _ if power % 2 == 0 && value < 0.0 => None,
        _ => Some(value.signum() * value.abs().powf(1.0 / f64::from(power))),
    }
}

/// Whether a curve is the upper one of its pair at the numbers: for a negative small parameter the
/// two may change places.
fn is_upper(
    curves: &TransitionCurves,
    curve: &TransitionCurve,
    numbers: &BTreeMap<Symbol, f64>,
) -> bool {
    let other = curves.curves.iter().find(|other| other.tongue == curve.tongue && *other != curve);
    let value = |curve| formula(curves, curve, numbers);
    match (value(curve), other.and_then(value)) {
        (Some(own), Some(other)) if own != other => own > other,
        _ => curve.upper,
    }
}

/// The value of the unknown at which the equation truly has the periodic motion of the curve;
/// `None` if its tongue is closed there.
fn true_value(
    curves: &TransitionCurves,
    curve: &TransitionCurve,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Option<f64>, HillError> {
    let unknown = curves.unknown.symbol();
    let with = |value: f64| {
        let mut numbers = numbers.clone();
        numbers.insert(unknown, value);
        numbers
    };
    let value = match curves.unknown {
        Unknown::Stiffness { power, .. } => {
            let slope = curves.stiffness.differentiate(unknown).ok();
            let slope = slope.ok_or(HillError::Coefficients)?;
            // The reference is zero if the unknown enters linearly; otherwise it is the value of
            // the formula, and then the results of two iterations.
            let mut reference = match power {
                1 => 0.0,
                _ => formula(curves, curve, numbers).filter(|value| *value != 0.0).unwrap_or(1.0),
            };
            let mut value = None;
            for _ in 0..if power == 1 { 1 } else { 3 } {
                // mu = r*(u - u_0) for the power u of the letter, that of the reference being u_0.
                let by_letter =
                    slope.evaluate(&with(reference)).map_err(|_| HillError::Coefficients)?;
                let slope = by_letter / (f64::from(power) * reference.powi(power - 1));
                let above = is_upper(curves, curve, numbers) == (slope > 0.0);
                let coefficients = SampledCoefficients::new(curves, &with(reference))?;
                let mu = coefficients.eigenvalue(curve, above)?;
                // A value below the rounding error is zero.
                let rounding = ROUNDING * coefficients.frequency.powi(2);
                let mu = mu.is_real.then_some(mu.value);
                let mu = mu.map(|mu| if mu.abs() < rounding { 0.0 } else { mu / slope });
                value = mu.and_then(|mu| {
                    letter_of_power(
                        mu + if power == 1 { 0.0 } else { reference.powi(power) },
                        power,
                    )
                });
                value = value.filter(|value| value.is_finite());
                let Some(better) = value else { break };
                reference = better;
            }
            value
        }
        Unknown::Frequency(_) => frequency_without_remainder(curves, curve, &with)?,
    };
    let Some(value) = value else {
        return Ok(None);
    };
    let numbers = with(value);
    let coefficients = SampledCoefficients::new(curves, &numbers)?;
    match coefficients.defect(curves, curve, &numbers) {
        Some(defect) if defect <= MULTIPLIER_TOLERANCE => Ok(Some(value)),
        _ => Err(HillError::NotConfirmed(curve.name.clone())),
    }
}

/// The frequency at which `mu` is zero: it grows with the frequency.
fn frequency_without_remainder(
    curves: &TransitionCurves,
    curve: &TransitionCurve,
    with: &dyn Fn(f64) -> BTreeMap<Symbol, f64>,
) -> Result<Option<f64>, HillError> {
    let upper = is_upper(curves, curve, &with(1.0));
    // mu grows with the frequency, so that the larger of the two reaches zero first.
    let mu = |frequency: f64| {
        SampledCoefficients::new(curves, &with(frequency))?.eigenvalue(curve, !upper)
    };
    // Without variation of the coefficients mu is n^2 Omega^2/4 less the mean stiffness.
    let unit = SampledCoefficients::new(curves, &with(1.0))?;
    let count = curve.tongue as f64 * unit.frequency;
    let mean = unit.mean_stiffness();
    if !(mean > 0.0 && count > 0.0) {
        return Ok(None);
    }
    let guess = 2.0 * mean.sqrt() / count;
    // The search goes on from there in the direction of the zero.
    const STEPS: i32 = 300;
    let (mut from, mut before) = (guess, mu(guess)?.value);
    let ratio = if before < 0.0 { 1.01_f64 } else { 1.0 / 1.01 };
    for _ in 0..STEPS {
        let next = from * ratio;
        let value = mu(next)?.value;
        if (before < 0.0) != (value < 0.0) {
            let value = |frequency: f64| mu(frequency).map_or(f64::NAN, |mu| mu.value);
            let Ok(root) = find_root(value, from, next) else {
                return Ok(None);
            };
            return Ok(mu(root)?.is_real.then_some(root));
        }
        (from, before) = (next, value);
    }
    Ok(None)
}

/// An eigenvalue, or the real part of a complex pair.
struct Eigenvalue {
    value: f64,
    is_real: bool,
}

/// `c` and `k` at equally spaced phases, in numbers.
struct SampledCoefficients {
    /// Frequency of the coefficients.
    frequency: f64,
    /// `(c, k)` over two periods.
    samples: Vec<[f64; 2]>,
    harmonics: usize,
}

impl SampledCoefficients {
    fn new(curves: &TransitionCurves, numbers: &BTreeMap<Symbol, f64>) -> Result<Self, HillError> {
        let value_of = |name: Symbol| numbers.get(&name).copied();
        let frequency = curves.frequency.polynomial().evaluate(value_of).unwrap_or(f64::NAN);
        if !(frequency > 0.0 && frequency.is_finite()) {
            return Err(HillError::Frequency(frequency));
        }
        let most = curves.curves.iter().map(|curve| curve.tongue).max().unwrap_or(0);
        let time = Symbol::new("t");
        let given = || numbers.iter().filter(|(name, _)| **name != time);
        let names: Vec<Symbol> = given().map(|(name, _)| *name).chain([time]).collect();
        let compiled = |expression: &Expr| {
            CompiledFunction::new(expression, &names).map_err(|_| HillError::Coefficients)
        };
        let [damping, stiffness] = [compiled(&curves.damping)?, compiled(&curves.stiffness)?];
        let sample = |count: usize| -> Result<Vec<[f64; 2]>, HillError> {
            let mut point: Vec<f64> = given().map(|(_, value)| *value).chain([0.0]).collect();
            let sample = |index: usize| {
                *point.last_mut()? = 2.0 * TAU / frequency * index as f64 / count as f64;
                let sample = [damping.call(&point), stiffness.call(&point)];
                sample.iter().all(|value| value.is_finite()).then_some(sample)
            };
            let samples: Option<Vec<[f64; 2]>> = (0..count).map(sample).collect();
            samples.ok_or(HillError::Coefficients)
        };
        let rough = sample(64)?;
        let largest = rough.iter().fold(0.0_f64, |largest, [c, k]| largest.max(c * c).max(k.abs()));
        let spare = SPARE_HARMONICS.max(TIMES_TAKEN_ON * curves.highest_harmonic);
        let wanted = (most + spare) as f64 + 4.0 * largest.sqrt() / frequency;
        if wanted > MOST_HARMONICS as f64 {
            return Err(HillError::Coefficients);
        }
        let harmonics = wanted.ceil() as usize;
        Ok(Self { frequency, samples: sample((8 * harmonics).max(512))?, harmonics })
    }

    fn mean_stiffness(&self) -> f64 {
        self.samples.iter().map(|sample| sample[1]).sum::<f64>() / self.samples.len() as f64
    }

    /// `mu` of a curve: the eigenvalues of `-(D^2 + c D + k)` on the motions of its period, in
    /// order. `above` asks for the larger one of its pair.
    fn eigenvalue(&self, curve: &TransitionCurve, above: bool) -> Result<Eigenvalue, HillError> {
        let odd = curve.tongue % 2;
        // The normalised waves: harmonic, and whether it is a sine.
        let waves: Vec<(usize, bool)> = (odd..=self.harmonics)
            .step_by(2)
            .flat_map(|k| [(k, false), (k, true)])
            .filter(|wave| *wave != (0, true))
            .filter(|(_, is_sine)| match curve.motion {
                WavesOfMotion::Cosines => !is_sine,
                WavesOfMotion::Sines => *is_sine,
                WavesOfMotion::Both => true,
            })
            .collect();
        let count = self.samples.len();
        let half = self.frequency / 2.0;
        let norm = |k: usize| {
            if k == 0 { 1.0 } else { std::f64::consts::SQRT_2 }
        };
        let round: Vec<(f64, f64)> =
            (0..count).map(|place| (TAU * place as f64 / count as f64).sin_cos()).collect();
        let mut at_samples = DMatrix::zeros(count, waves.len());
        let mut images = DMatrix::zeros(count, waves.len());
        for (row, [c, k]) in self.samples.iter().enumerate() {
            for (column, (harmonic, is_sine)) in waves.iter().enumerate() {
                // The index is reduced in whole numbers, so that the waves are orthogonal to the
                // last digit.
                let (sine, cosine) = round[(harmonic * row) % count];
                let rate = *harmonic as f64 * half;
                let (value, slope) =
                    if *is_sine { (sine, rate * cosine) } else { (cosine, -rate * sine) };
                at_samples[(row, column)] = norm(*harmonic) * value;
                images[(row, column)] =
                    norm(*harmonic) * (rate * rate * value - c * slope - k * value);
            }
        }
        let matrix = at_samples.transpose() * images / count as f64;
        let size = matrix.norm();
        if !size.is_finite() {
            return Err(HillError::Coefficients);
        }
        let undamped = self.samples.iter().all(|[c, _]| *c == 0.0);
        let mut values: Vec<(f64, f64)> = if undamped {
            let eigen = SymmetricEigen::try_new(matrix, f64::EPSILON, 10_000)
                .ok_or(HillError::Coefficients)?;
            eigen.eigenvalues.iter().map(|value| (*value, 0.0)).collect()
        } else {
            let schur =
                Schur::try_new(matrix, f64::EPSILON, 10_000).ok_or(HillError::Coefficients)?;
            schur.complex_eigenvalues().iter().map(|value| (value.re, value.im)).collect()
        };
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        // With cosines and sines, tongue 0 comes before the pairs; with one kind alone, there is
        // one eigenvalue for every second tongue.
        let index = match (curve.motion, curve.tongue) {
            (WavesOfMotion::Sines, tongue) => (tongue - 1) / 2,
            (WavesOfMotion::Cosines, tongue) => tongue / 2,
            (WavesOfMotion::Both, 0) => 0,
            (WavesOfMotion::Both, tongue) => tongue - 1 + usize::from(above),
        };
        let (value, imaginary) = values.get(index).copied().ok_or(HillError::Coefficients)?;
        Ok(Eigenvalue { value, is_real: imaginary.abs() <= REAL * size })
    }

    /// `|1 -+ tr Phi + det Phi|` of the integrated motion over the size of its terms.
    fn defect(
        &self,
        curves: &TransitionCurves,
        curve: &TransitionCurve,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Option<f64> {
        let names = [curves.equation.coordinate, curves.equation.coordinate.derivative()];
        let [x, v] = names.map(Expr::from);
        let rate = -(&(&curves.stiffness * &x) + &(&curves.damping * &v));
        let system = System::new(&names, "t".into(), &[v, rate], numbers).ok()?;
        let period = TAU / self.frequency;
        let column = |start: [f64; 2]| {
            let path = system.solve([0.0, period], &start, &[], &SystemOptions::default()).ok()?;
            path.states_at(period)
        };
        let (first, second) = (column([1.0, 0.0])?, column([0.0, 1.0])?);
        let trace = first.first()? + second.get(1)?;
        let determinant = first.first()? * second.get(1)? - first.get(1)? * second.first()?;
        let sign = if curve.tongue.is_multiple_of(2) { 1.0 } else { -1.0 };
        Some((1.0 - sign * trace + determinant).abs() / (1.0 + trace.abs() + determinant.abs()))
    }
}

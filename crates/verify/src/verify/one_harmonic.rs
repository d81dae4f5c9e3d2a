//! Modes with one harmonic beside the true motions, by shooting over half a period from the same start.

use std::collections::BTreeMap;

use super::normal_mode::{TrueMode, checked};
use super::{Verdict, VerificationError};
use crate::expr::{CompiledList, Expr};
use crate::modes::{OneHarmonicFamily, OneHarmonicModes};
use crate::numeric::ode::root::find_root;
use crate::solution::defined_values;
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FREQUENCY};
use crate::values::Values;

/// Modes with one harmonic at an amplitude, judged.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct JudgedOneHarmonic {
    /// The values.
    pub at: Values,
    /// The relative error up to which they pass.
    pub tolerance: f64,
    /// The motions at the amplitude, the slowest first.
    pub motions: Vec<OneHarmonicMotion>,
    /// Whether all of them are within the tolerance.
    pub verdict: Verdict,
}

/// A motion with one harmonic, `x = A cos(omega t)`, `y = r x`.
#[derive(Clone, Debug)]
pub struct OneHarmonicMotion {
    /// The index of its family.
    pub family: usize,
    /// The ratio r.
    pub ratio: f64,
    /// omega.
    pub frequency: f64,
    /// omega of the true motion whose first coordinate starts at A, all velocities zero; `None` if none
    /// was found near.
    pub true_frequency: Option<f64>,
    /// `frequency / true_frequency - 1`.
    pub relative_error: Option<f64>,
}

/// Judges modes with one harmonic at values of the amplitude and of all parameters.
///
/// # Errors
/// [`VerificationError`] for missing or unknown values, and where no mode has this amplitude.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::modes::{FreeSystem, one_harmonic_modes};
/// use lindstedt::verify::judge_one_harmonic;
///
/// let pair = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0")?;
/// let judged = judge_one_harmonic(&one_harmonic_modes(&pair)?, &"A = 1.1264".parse()?, 0.01)?;
/// assert!((judged.motions[0].frequency - 1.1).abs() < 1e-4);
/// assert!(judged.motions[0].true_frequency.is_some_and(|omega| (omega - 1.0984).abs() < 1e-4));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn judge_one_harmonic(
    modes: &OneHarmonicModes,
    at: &Values,
    tolerance: f64,
) -> Result<JudgedOneHarmonic, VerificationError> {
    let numbers = checked(&modes.system, AMPLITUDE, at)?;
    let amplitude = numbers[&AMPLITUDE];
    if amplitude == 0.0 {
        return Err(VerificationError::AtRest);
    }
    let truth = TrueMode::from_start(&modes.system, &numbers)?;
    let defined = defined_values(&modes.definitions, &|name| numbers.get(&name).copied())
        .map_err(|name| VerificationError::Missing(vec![name]))?;
    let values: BTreeMap<Symbol, f64> = numbers.into_iter().chain(defined).collect();
    let mut motions = Vec::new();
    for (index, family) in modes.families.iter().enumerate() {
        let found = members(family, modes.ratio, &values)
            .map_err(|error| VerificationError::NoSystem(error.to_string()))?;
        for [ratio, frequency] in found {
            let true_frequency = truth.frequency_near(&[amplitude, ratio * amplitude], frequency);
            motions.push(OneHarmonicMotion {
                family: index,
                ratio,
                frequency,
                true_frequency,
                relative_error: true_frequency.map(|truth| frequency / truth - 1.0),
            });
        }
    }
    motions.sort_by(|one, other| one.frequency.total_cmp(&other.frequency));
    let within = |motion: &OneHarmonicMotion| {
        motion.relative_error.is_some_and(|error| error.abs() <= tolerance)
    };
    let verdict = Verdict::from_passed(!motions.is_empty() && motions.iter().all(within));
    Ok(JudgedOneHarmonic { at: at.clone(), tolerance, motions, verdict })
}

/// Ratio and frequency of the members of a family with the amplitude.
fn members(
    family: &OneHarmonicFamily,
    ratio: Symbol,
    values: &BTreeMap<Symbol, f64>,
) -> Result<Vec<[f64; 2]>, Box<dyn std::error::Error>> {
    let pi = [(Symbol::new("pi"), std::f64::consts::PI)];
    let known: BTreeMap<Symbol, f64> =
        values.iter().map(|(name, value)| (*name, *value)).chain(pi).collect();
    let square = known.get(&AMPLITUDE).map_or(f64::NAN, |amplitude| amplitude * amplitude);
    let real = |found: [f64; 2]| {
        let root = found[1].sqrt();
        (found[0].is_finite() && root.is_finite() && root > 0.0).then_some([found[0], root])
    };
    // The places along a parameter where A^2 is the given one, with ratio and omega^2 there.
    let along = |name: Symbol,
                 amplitude_squared: &Expr,
                 result: [&Expr; 2],
                 signs: &[f64]|
     -> Result<Vec<[f64; 2]>, Box<dyn std::error::Error>> {
        let names: Vec<Symbol> = known.keys().copied().filter(|own| *own != name).collect();
        let mut arguments: Vec<f64> = names.iter().map(|own| known[own]).collect();
        arguments.push(0.0);
        let names: Vec<Symbol> = names.into_iter().chain([name]).collect();
        let all = [amplitude_squared.clone(), result[0].clone(), result[1].clone()];
        let compiled = CompiledList::new(&all, &names)?;
        let mut at = |place: f64| {
            let last = arguments.len() - 1;
            arguments[last] = place;
            let mut found = [f64::NAN; 3];
            compiled.call(&arguments, &mut vec![], &mut found);
            found
        };
        Ok(signs
            .iter()
            .flat_map(|sign| {
                places(&mut |size| at(sign * size)[0] - square)
                    .into_iter()
                    .map(move |size| sign * size)
            })
            .collect::<Vec<f64>>()
            .into_iter()
            .filter_map(|place| {
                let [_, first, second] = at(place);
                real([first, second])
            })
            .collect())
    };
    let omega = Expr::from(FREQUENCY);
    match family {
        OneHarmonicFamily::Similar { ratio, frequency_squared } => {
            let evaluated = |expression: &Expr| expression.evaluate(&known).unwrap_or(f64::NAN);
            Ok(real([evaluated(ratio), evaluated(frequency_squared)]).into_iter().collect())
        }
        OneHarmonicFamily::AlongRatio { amplitude_squared, frequency_squared } => {
            along(ratio, amplitude_squared, [&Expr::from(ratio), frequency_squared], &[1.0, -1.0])
        }
        OneHarmonicFamily::AlongFrequency { ratio, amplitude_squared } => {
            along(FREQUENCY, amplitude_squared, [ratio, &(&omega * &omega)], &[1.0])
        }
    }
}

/// The places from 1e-4 to 1e4 where a function changes its sign and is near zero.
fn places(value: &mut dyn FnMut(f64) -> f64) -> Vec<f64> {
    /// Steps of each decade.
    const STEPS: i32 = 2_000;
    let size = |step: i32| 10.0_f64.powf(f64::from(step) / f64::from(STEPS));
    let mut found = Vec::new();
    let mut last = (size(-4 * STEPS), value(size(-4 * STEPS)));
    for step in 1 - 4 * STEPS..=4 * STEPS {
        let next = (size(step), value(size(step)));
        if last.1 * next.1 < 0.0 {
            // At a pole the sign changes as well.
            let largest = last.1.abs().max(next.1.abs());
            let root = find_root(&mut *value, last.0, next.0).ok();
            found.extend(root.filter(|root| value(*root).abs() <= largest));
        }
        last = next;
    }
    found
}

//! The numbers of a certificate of a limit cycle or a driven motion: Newton's iteration from the
//! true motion in doubles. The theorem trusts nothing here.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::DMatrix;
use num_traits::{Signed as _, Zero as _};

use super::super::candidate::{
    BITS, INVERSE_BITS, NOISE, NotCertified, blocks, claim_errors, claimed, few_units, inverted,
    iterate, judged, not_proved, shorten, subtract, units, weight, without_claims, written_out,
};
use super::super::force::{is_even, is_odd};
use super::super::formula::JudgedFormula;
use super::super::fourier_series::{BasisFunction, FourierSeries, WORKING};
use super::super::law;
use super::super::radii_polynomial::{Correction, NotProved};
use super::super::{Certified, HIGHEST_HARMONIC, coordinate};
use super::problem::CoordinateWave;
use super::theorem::{correction, derivative_of_block, prove};
use super::waves::{displacement, in_waves};
use super::{ClaimedStability, DampedCertificate, Drive};
use crate::exact::ball::{Ball, Balls};
use crate::exact::bound::Bound;
use crate::exact::rational::from_f64;
use crate::exact::{Integer, Rational};
use crate::expr::{Expr, ExprError};
use crate::numeric::harmonics::{Harmonics, Transform};
use crate::oscillator::{Oscillator, Parts};
use crate::solution::Solution;
use crate::symbol::Symbol;
use crate::values::Values;
use crate::verify;

/// A certificate of the limit cycle that a formula is about, and what it proves of the formula.
///
/// # Errors
/// [`NotCertified`].
pub fn certify_cycle(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
) -> Result<(DampedCertificate, Certified), NotCertified> {
    certified_cycle(oscillator, solution, at, true)
}

/// A certificate of the limit cycle that a formula is about, without the formula: the formula may
/// have no value there.
///
/// # Errors
/// [`NotCertified`].
pub fn certify_cycle_motion(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
) -> Result<(DampedCertificate, Certified), NotCertified> {
    certified_cycle(oscillator, solution, at, false)
}

fn certified_cycle(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
    with_formula: bool,
) -> Result<(DampedCertificate, Certified), NotCertified> {
    let _letters = oscillator.letters().in_force();
    if at.get(solution.amplitude.symbol()).is_some() {
        return Err(NotCertified::OffCycle);
    }
    let [damping, force] = lienard(oscillator, at)?;
    let samples = verify::true_motion(oscillator, solution, at)?;
    let (values, _) = at.split(&oscillator.parameters);
    let equilibrium = solution.equilibrium.substitute_all(&values)?;
    let odd = equilibrium.is_zero()
        && is_odd(&force, &[coordinate()])?
        && is_even(&damping, &[coordinate()])?;
    let (reciprocal, harmonics) = from_samples(&samples, odd);
    let seen = harmonics.cosines.len().max(harmonics.sines.len());
    if seen >= HIGHEST_HARMONIC {
        return Err(NotCertified::TooManyHarmonics(HIGHEST_HARMONIC));
    }
    let bits = digits(seen);
    let formula = match with_formula {
        true => Some(judged(solution, at, bits)?),
        false => None,
    };
    let coefficients = |values: &[f64]| values.iter().map(|value| units(*value, bits)).collect();
    let mut certificate = DampedCertificate {
        damping,
        force,
        drive: None,
        odd,
        bits,
        reciprocal: units(reciprocal, bits),
        cosines: coefficients(&harmonics.cosines),
        sines: coefficients(&harmonics.sines),
        // With many harmonics few steps suffice; the number that a proof needs is found later.
        highest: (3 * seen / 2).clamp(15, last_harmonic_of_largest_block(odd)) | 1,
        inverse_bits: INVERSE_BITS,
        inverse: vec![],
        sigma: 0,
        claim: Rational::zero(),
        stability: None,
        formula,
    };
    certificate.well_formed_formula().map_err(NotCertified::Formula)?;
    let certified = proved_by_some_block(&mut certificate, seen)?;
    Ok((certificate, certified))
}

/// A certificate of the steady motion that the verdict on a driven formula is about, the largest
/// stable one, and what it proves of the formula.
///
/// # Errors
/// [`NotCertified`].
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::{certify_driven, check_damped};
/// use lindstedt::{Oscillator, Options, solve};
///
/// let oscillator = Oscillator::parse("x'' + x'/5 + x + x^3/10 - cos(Omega*t)/10 = 0")?;
/// let solution = solve(&oscillator, &Options::default())?;
/// let (certificate, certified) = certify_driven(&oscillator, &solution, &"Omega = 1".parse()?)?;
/// let amplitude = certified.amplitude.as_ref().ok_or("no amplitude")?;
/// assert!(amplitude.radius.value() < 1e-30);
/// assert_eq!(check_damped(&certificate)?, certified);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn certify_driven(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
) -> Result<(DampedCertificate, Certified), NotCertified> {
    let _letters = oscillator.letters().in_force();
    let resonance = solution.modulation.as_ref().and_then(|slow| slow.resonance.as_ref());
    let resonance = resonance.ok_or(NotCertified::NoSteadyMotion)?;
    let (values, _) = at.split(&oscillator.parameters);
    let given = resonance.driving_frequency.substitute_all(&values)?.expand()?;
    let frequency = given.as_number().map(|number| number.abs()).filter(|number| !number.is_zero());
    let frequency = frequency.ok_or_else(|| NotCertified::DrivingFrequency(given.to_string()))?;
    let [damping, force] = driven_parts(oscillator, &values, &frequency)?;
    let samples = verify::motions(oscillator, solution, at)?.ok_or(NotCertified::NoSteadyMotion)?;
    let places = |samples: &[verify::TimedState]| -> Vec<f64> {
        samples[..samples.len() - 1].iter().map(|(_, x, _)| *x).collect()
    };
    let truth = harmonics_of(&places(&samples.truth));
    let seen = truth.cosines.len().max(truth.sines.len());
    let drive = Drive {
        frequency,
        periods: resonance.times_linear as usize,
        harmonic: resonance.times_driving as usize,
    };
    let harmonic = drive.harmonic;
    let own = |harmonics: &Harmonics| {
        let part = |list: &[f64]| list.get(harmonic).copied().unwrap_or(0.0);
        part(&harmonics.cosines).hypot(part(&harmonics.sines))
    };
    let formula = harmonics_of(&places(&samples.formula));
    if own(&truth) < NOISE || own(&formula) < NOISE {
        return Err(NotCertified::NoSteadyMotion);
    }
    if seen >= HIGHEST_HARMONIC / 2 {
        return Err(NotCertified::TooManyHarmonics(HIGHEST_HARMONIC / 2));
    }
    let bits = digits(seen);
    let coefficients = |values: &[f64]| values.iter().map(|value| units(*value, bits)).collect();
    let judged = judged_driven(solution, at, &formula, &drive, bits);
    let mut certificate = DampedCertificate {
        damping,
        force,
        drive: Some(drive),
        odd: false,
        bits,
        reciprocal: Integer::zero(),
        cosines: coefficients(&truth.cosines),
        sines: coefficients(&truth.sines),
        highest: 1,
        inverse_bits: INVERSE_BITS,
        inverse: vec![],
        sigma: 0,
        claim: Rational::zero(),
        stability: None,
        formula: Some(judged),
    };
    // A motion of an odd equation need not be odd: after its symmetry is broken it is not.
    certificate.odd = has_odd_alone(&truth) && certificate.is_odd()?;
    if certificate.odd {
        for list in [&mut certificate.cosines, &mut certificate.sines] {
            list.iter_mut().step_by(2).for_each(|even| *even = Integer::zero());
        }
    }
    certificate.highest =
        (3 * seen / 2).clamp(15, last_harmonic_of_largest_block(certificate.odd)) | 1;
    let certified = proved_by_some_block(&mut certificate, seen)?;
    Ok((certificate, certified))
}

/// The formula of a driven motion, with these harmonics. Where its displacement, as text, is that
/// of one of its steady motions, the harmonics are those of the text to their last digits.
fn judged_driven(
    solution: &Solution,
    at: &Values,
    harmonics: &Harmonics,
    drive: &Drive,
    bits: usize,
) -> JudgedFormula {
    let mut judged = without_claims([&harmonics.cosines, &harmonics.sines], bits);
    judged.law = solution.title();
    let (Some(response), Some(slow)) = (&solution.response, &solution.modulation) else {
        return judged;
    };
    let coordinate = solution.coordinate().to_string();
    let written = law::with_definitions(solution, &coordinate, &response.motion, |definition| {
        definition.meaning.to_string()
    });
    for state in solution.steady_states(&|name| at.get(name)) {
        let mut values = at.clone();
        let number = |value: f64| Expr::number(from_f64(value).unwrap_or_default());
        // Amplitude and phase of the slow equations get their steady values.
        let taken = [(slow.amplitude, state.amplitude), (slow.phase, state.phase)]
            .into_iter()
            .any(|(name, value)| values.insert(name, number(value)).is_err());
        let values = law::values_in(&written, &values);
        let Some(exact) = displacement(&written, &values, drive).filter(|_| !taken) else {
            continue;
        };
        if is_near_all(&exact, harmonics) {
            let in_units = |ball: &Ball| Balls { bits }.converted(ball, WORKING).middle;
            judged.coefficients = exact.cosines.iter().map(in_units).collect();
            judged.sines = exact.sines.iter().map(in_units).collect();
            (judged.law, judged.values) = (written, values);
            break;
        }
    }
    judged
}

/// Returns whether a series has these harmonics up to the rounding of doubles.
fn is_near_all(exact: &FourierSeries, harmonics: &Harmonics) -> bool {
    const ROUNDING: f64 = 1e-9;
    let own = |list: &[f64], k: usize| list.get(k).copied().unwrap_or(0.0);
    let size = harmonics.cosines.iter().chain(&harmonics.sines);
    let size = size.fold(0.0_f64, |most, value| most.max(value.abs()));
    let near = |ball: &Ball, double: f64| (WORKING.nearest(ball) - double).abs() <= ROUNDING * size;
    let last = exact.length().max(harmonics.cosines.len()).max(harmonics.sines.len());
    (0..last).all(|k| {
        near(&exact.cosine(k), own(&harmonics.cosines, k))
            && near(&exact.sine(k), own(&harmonics.sines, k))
    })
}

/// The harmonics of samples of one period, the constant being the mean, without trailing ones that
/// have no significant digits.
fn harmonics_of(places: &[f64]) -> Harmonics {
    let mut found =
        Transform::new(places.len()).harmonics(places, HIGHEST_HARMONIC.min(places.len() / 2));
    // The coefficient of the constant was twice the mean.
    found.cosines[0] /= 2.0;
    let largest = found.cosines.iter().chain(&found.sines);
    let largest = largest.fold(0.0_f64, |most, value| most.max(value.abs()));
    for list in [&mut found.cosines, &mut found.sines] {
        while list.len() > 2 && list.last().is_some_and(|last| last.abs() < NOISE * largest) {
            list.pop();
        }
    }
    found
}

/// Whether the even harmonics are zero up to numerical noise.
fn has_odd_alone(harmonics: &Harmonics) -> bool {
    let all = || harmonics.cosines.iter().chain(&harmonics.sines);
    let largest = all().fold(0.0_f64, |most, value| most.max(value.abs()));
    let even = [&harmonics.cosines, &harmonics.sines].map(|list| list.iter().step_by(2));
    even.into_iter().flatten().all(|value| value.abs() < 1e3 * NOISE * largest)
}

/// g and h of `x'' + g(x) x' + h(x, cos(Omega t), sin(Omega t)) = 0`, with numbers.
fn driven_parts(
    oscillator: &Oscillator,
    values: &BTreeMap<Symbol, Expr>,
    frequency: &Rational,
) -> Result<[Expr; 2], NotCertified> {
    let (time, velocity) = (Symbol::new("t"), oscillator.velocity());
    for term in oscillator.force.terms() {
        if !is_linear_in(term, velocity)? || term.differentiate(velocity)?.contains(time) {
            return Err(NotCertified::NotDriven(term.to_string()));
        }
    }
    let in_numbers = |expression: Expr| {
        let expression = expression.substitute_all(values)?;
        // The coordinate is substituted first, because its name may be that of a wave.
        let expression = expression.substitute(oscillator.coordinate, &Expr::from(coordinate()))?;
        in_waves(&expression, time, frequency)
    };
    let damping = in_numbers(oscillator.force.differentiate(velocity)?)?;
    let force = in_numbers(oscillator.force.substitute(velocity, &Expr::zero())?)?;
    Ok([written_out(damping, &[coordinate()])?, force])
}

/// Refines a certificate, and finds the smallest block that proves it.
///
/// # Errors
/// As [`certify_cycle`].
pub(super) fn proved_by_some_block(
    certificate: &mut DampedCertificate,
    seen: usize,
) -> Result<Certified, NotCertified> {
    refine(certificate)
        .map_err(|reason| not_proved(reason, certificate.problem().block().len()))?;
    let mut reason = NotProved::NoContraction(Bound::UNKNOWN);
    let most = last_harmonic_of_largest_block(certificate.odd);
    for highest in blocks(seen).take_while(|highest| *highest <= most) {
        certificate.highest = highest;
        match proved(certificate) {
            Ok(certified) => return Ok(certified),
            Err(error @ NotProved::NoContraction(_)) => reason = error,
            Err(error) => return Err(not_proved(error, certificate.problem().block().len())),
        }
    }
    Err(not_proved(reason, certificate.problem().block().len()))
}

/// The last harmonic of the largest block; without symmetry one has twice as many unknowns.
const fn last_harmonic_of_largest_block(odd: bool) -> usize {
    match odd {
        true => HIGHEST_HARMONIC - 1,
        false => HIGHEST_HARMONIC / 2 - 1,
    }
}

/// Binary digits behind the point, the fewer the more harmonics a motion has: with the digits grows
/// the number of harmonics, and with its square the time.
fn digits(seen: usize) -> usize {
    /// Number of harmonics in doubles up to which all digits are used.
    const MANY: usize = 120;
    /// The least number of bits: those of doubles.
    const FEWEST: usize = 60;
    (BITS * MANY / seen.max(1)).clamp(FEWEST, BITS)
}

/// g and h of `x'' + g(x) x' + h(x) = 0`, with numbers.
fn lienard(oscillator: &Oscillator, at: &Values) -> Result<[Expr; 2], NotCertified> {
    let parts = oscillator.parts()?;
    if !parts.forcing.is_zero() {
        return Err(NotCertified::NotConservative(parts.forcing.to_string()));
    }
    let velocity = oscillator.velocity();
    let mut terms = parts.damping.terms().to_vec();
    terms.extend(parts.inertia.terms().iter().filter(|term| !term.is_zero()).cloned());
    for term in terms {
        if !is_linear_in(&term, velocity)? {
            return Err(NotCertified::NotLienard {
                term: term.to_string(),
                of_velocity: of_velocity(oscillator, &parts),
            });
        }
    }
    let (values, _) = at.split(&oscillator.parameters);
    let in_numbers = |expression: Expr| {
        let expression = expression.substitute_all(&values)?;
        let expression = expression.substitute(oscillator.coordinate, &Expr::from(coordinate()))?;
        written_out(expression, &[coordinate()])
    };
    let damping = oscillator.force.differentiate(velocity)?;
    let force = oscillator.force.substitute(velocity, &Expr::zero())?;
    Ok([in_numbers(damping)?, in_numbers(force)?])
}

/// Whether a term is a multiple of a symbol, or free of it. The derivative alone does not decide:
/// that of `sgn` is zero.
pub(super) fn is_linear_in(term: &Expr, letter: Symbol) -> Result<bool, ExprError> {
    let slope = term.differentiate(letter)?;
    let rest = (term - &(&slope * &Expr::from(letter))).expand()?;
    Ok(!slope.contains(letter) && !rest.contains(letter))
}

/// The equation of `v = x'`, `v'' + D'(v) v' + k v = 0` where that of x is `x'' + D(x') + k x = 0`,
/// written with the symbol of x.
fn of_velocity(oscillator: &Oscillator, parts: &Parts) -> Option<String> {
    let (coordinate, velocity) = (oscillator.coordinate, oscillator.velocity());
    let stiffness = parts.restoring.differentiate(coordinate).ok()?;
    let lost = &parts.damping + &parts.inertia;
    let linear = !stiffness.contains(coordinate)
        && !lost.contains(coordinate)
        && parts.restoring.substitute(coordinate, &Expr::zero()).ok()?.is_zero();
    let slope = lost.differentiate(velocity).ok()?;
    let damping = slope.substitute(velocity, &Expr::from(coordinate)).ok()?;
    let drag = &damping * &Expr::from(velocity);
    let force = &drag + &(&stiffness * &Expr::from(coordinate));
    let acceleration = Expr::from(velocity.derivative());
    linear.then(|| format!("{} = 0", &acceleration + &force))
}

/// `1/omega` and the harmonics of one period, turned so that the first one is a positive cosine.
fn from_samples(samples: &[verify::TimedState], odd: bool) -> (f64, Harmonics) {
    let count = samples.len() - 1;
    let places: Vec<f64> = samples[..count].iter().map(|(_, x, _)| *x).collect();
    let mut found = Transform::new(count).harmonics(&places, HIGHEST_HARMONIC.min(count / 2));
    // The coefficient of the constant was twice the mean.
    found.cosines[0] /= 2.0;
    let mut turned = phase_shifted(&found, phase_of(&found));
    turned.sines[1] = 0.0;
    let largest = turned.cosines.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    for list in [&mut turned.cosines, &mut turned.sines] {
        if odd {
            list.iter_mut().step_by(2).for_each(|even| *even = 0.0);
        }
        while list.len() > 2 && list.last().is_some_and(|last| last.abs() < NOISE * largest) {
            list.pop();
        }
    }
    (samples[count].0 / TAU, turned)
}

/// The angle at which the first harmonic is largest.
pub(super) fn phase_of(harmonics: &Harmonics) -> f64 {
    harmonics.sines[1].atan2(harmonics.cosines[1])
}

/// The harmonics of the same function, of the angle from this phase on.
pub(super) fn phase_shifted(harmonics: &Harmonics, phase: f64) -> Harmonics {
    let mut shifted = Harmonics { cosines: vec![harmonics.cosines[0]], sines: vec![0.0] };
    let length = harmonics.cosines.len().max(harmonics.sines.len());
    let entry = |list: &[f64], k: usize| list.get(k).copied().unwrap_or(0.0);
    for k in 1..length {
        let (a, b) = (entry(&harmonics.cosines, k), entry(&harmonics.sines, k));
        let (sine, cosine) = (k as f64 * phase).sin_cos();
        shifted.cosines.push(a * cosine + b * sine);
        shifted.sines.push(b * cosine - a * sine);
    }
    shifted
}

/// The inverse of the derivative on the block, in doubles.
fn inverse(certificate: &DampedCertificate) -> Result<Vec<Vec<Integer>>, NotProved> {
    let rows = derivative_of_block(certificate.problem())?;
    inverted(DMatrix::from_fn(rows.len(), rows.len(), |row, column| rows[row][column]))
}

/// Newton's iteration with one inverse.
fn refine(certificate: &mut DampedCertificate) -> Result<(), NotProved> {
    let bits = certificate.bits;
    certificate.inverse = inverse(certificate)?;
    let step = |certificate: &DampedCertificate| correction(certificate.problem());
    iterate(certificate, few_units(bits), step, |certificate, step| {
        let block = certificate.problem().block();
        let reciprocal = certificate.drive.is_none().then_some(&mut certificate.reciprocal);
        let lists = [&mut certificate.cosines, &mut certificate.sines].map(std::slice::from_mut);
        subtract_step(reciprocal, lists, &block, bits, step);
        shorten(&mut certificate.cosines);
        shorten(&mut certificate.sines);
    })
}

/// Subtracts a step of Newton's iteration from `1/omega`, which is the first unknown of the block
/// if the drive does not give it, and from the cosines and the sines of each coordinate.
pub(super) fn subtract_step(
    reciprocal: Option<&mut Integer>,
    [cosines, sines]: [&mut [Vec<Integer>]; 2],
    block: &[CoordinateWave],
    bits: usize,
    step: &Correction<CoordinateWave>,
) {
    let short = |ball| Balls { bits }.converted(ball, WORKING).middle;
    let first = usize::from(reciprocal.is_some());
    if let Some(reciprocal) = reciprocal {
        *reciprocal -= short(&step.block[0]);
    }
    let corrections = block[first..].iter().zip(&step.block[first..]);
    for (wave, ball) in corrections.chain(step.beyond.iter().map(|(wave, ball)| (wave, ball))) {
        let (list, k) = match wave.function {
            BasisFunction::Cosine(k) => (&mut cosines[wave.coordinate], k),
            BasisFunction::Sine(k) => (&mut sines[wave.coordinate], k),
        };
        subtract(list, k, short(ball));
    }
}

/// Checks a certificate with its block, and enters the proved values as claims.
fn proved(certificate: &mut DampedCertificate) -> Result<Certified, NotProved> {
    certificate.inverse = inverse(certificate)?;
    if certificate.drive.is_none() {
        certificate.sigma = weight(&certificate.inverse);
    }
    let proof = prove(certificate.problem())?;
    [_, certificate.claim] = claimed(proof.radius.value());
    let certified = certificate.certified(proof)?;
    claim_errors(certificate.formula.as_mut(), &certified);
    certificate.stability = certified.stability.as_ref().map(ClaimedStability::of);
    Ok(certified)
}

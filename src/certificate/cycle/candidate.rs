//! The numbers of a certificate of a limit cycle: Newton's iteration from the true cycle in doubles. Nothing here is trusted.

use std::f64::consts::TAU;

use nalgebra::DMatrix;
use num_traits::Zero as _;

use super::super::candidate::{
    BITS, INVERSE_BITS, NOISE, NotCertified, blocks, claim_errors, claimed, few_units, inverted, iterate, judged,
    not_proved, shorten, subtract, units, weight, written_out,
};
use super::super::force::{is_even, is_odd};
use super::super::fourier_series::{WORKING, Wave};
use super::super::radii_polynomial::NotProved;
use super::super::{Certified, HIGHEST_HARMONIC, coordinate};
use super::CycleCertificate;
use super::theorem::{correction, derivative_of_block, prove};
use crate::exact::Rational;
use crate::exact::ball::Balls;
use crate::exact::bound::Bound;
use crate::expr::Expr;
use crate::method::motion::NoMotion;
use crate::numeric::harmonics::{Harmonics, Transform};
use crate::oscillator::{Oscillator, Parts};
use crate::solution::Solution;
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
) -> Result<(CycleCertificate, Certified), NotCertified> {
    if at.get(solution.amplitude.symbol()).is_some() {
        return Err(NotCertified::OffCycle);
    }
    let [damping, force] = lienard(oscillator, at)?;
    let samples = verify::motions(oscillator, solution, at)?
        .ok_or(NoMotion::NotReal)?
        .truth;
    let (values, _) = at.split(&oscillator.parameters);
    let equilibrium = solution.equilibrium.substitute_all(&values)?;
    let odd = equilibrium.is_zero() && is_odd(&force)? && is_even(&damping)?;
    let (reciprocal, harmonics) = from_samples(&samples, odd);
    let seen = harmonics.cosines.len().max(harmonics.sines.len());
    if seen >= HIGHEST_HARMONIC {
        return Err(NotCertified::TooManyHarmonics(HIGHEST_HARMONIC));
    }
    let bits = digits(seen);
    let formula = judged(solution, at, bits)?;
    let coefficients = |values: &[f64]| values.iter().map(|value| units(*value, bits)).collect();
    let mut certificate = CycleCertificate {
        damping,
        force,
        odd,
        bits,
        reciprocal: units(reciprocal, bits),
        cosines: coefficients(&harmonics.cosines),
        sines: coefficients(&harmonics.sines),
        // Many harmonics bring it near in few steps; how many a proof needs is another question.
        highest: (3 * seen / 2).clamp(15, most(odd)) | 1,
        inverse_bits: INVERSE_BITS,
        inverse: vec![],
        sigma: 0,
        claim: Rational::zero(),
        formula: Some(formula),
    };
    let certified = proved_by_some_block(&mut certificate, seen)?;
    Ok((certificate, certified))
}

/// Brings a certificate near, and finds the smallest block that proves it.
///
/// # Errors
/// As [`certify_cycle`].
pub(super) fn proved_by_some_block(certificate: &mut CycleCertificate, seen: usize) -> Result<Certified, NotCertified> {
    refine(certificate).map_err(|reason| not_proved(reason, certificate.block().len()))?;
    let mut reason = NotProved::NoContraction(Bound::UNKNOWN);
    let most = most(certificate.odd);
    for highest in blocks(seen).take_while(|highest| *highest <= most) {
        certificate.highest = highest;
        match proved(certificate) {
            Ok(certified) => return Ok(certified),
            Err(error @ NotProved::NoContraction(_)) => reason = error,
            Err(error) => return Err(not_proved(error, certificate.block().len())),
        }
    }
    Err(not_proved(reason, certificate.block().len()))
}

/// The last harmonic of the largest block; without symmetry one has twice as many unknowns.
const fn most(odd: bool) -> usize {
    match odd {
        true => HIGHEST_HARMONIC - 1,
        false => HIGHEST_HARMONIC / 2 - 1,
    }
}

/// Binary digits behind the point: fewer of a motion of more harmonics, for the number of harmonics and with its square the time grow with
/// them.
fn digits(seen: usize) -> usize {
    /// A motion of so many harmonics in doubles has all digits.
    const MANY: usize = 120;
    /// No fewer: those of the doubles.
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
        if term.differentiate(velocity)?.contains(velocity) {
            return Err(NotCertified::NotLienard {
                term: term.to_string(),
                of_velocity: of_velocity(oscillator, &parts),
            });
        }
    }
    let (values, _) = at.split(&oscillator.parameters);
    let in_numbers = |expression: Expr| {
        let expression = expression.substitute_all(&values)?;
        written_out(expression.substitute(oscillator.coordinate, &Expr::from(coordinate()))?)
    };
    let damping = oscillator.force.differentiate(velocity)?;
    let force = oscillator.force.substitute(velocity, &Expr::zero())?;
    Ok([in_numbers(damping)?, in_numbers(force)?])
}

/// The equation of `v = x'`, `v'' + D'(v) v' + k v = 0` where that of x is `x'' + D(x') + k x = 0`, in the letter of x.
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
fn from_samples(samples: &[verify::Sample], odd: bool) -> (f64, Harmonics) {
    let count = samples.len() - 1;
    let places: Vec<f64> = samples[..count].iter().map(|(_, x, _)| *x).collect();
    let found = Transform::new(count).harmonics(&places, HIGHEST_HARMONIC.min(count / 2));
    let phase = found.sines[1].atan2(found.cosines[1]);
    let mut turned = Harmonics {
        cosines: vec![found.cosines[0] / 2.0],
        sines: vec![0.0],
    };
    for (k, (a, b)) in found.cosines.iter().zip(&found.sines).enumerate().skip(1) {
        let (sine, cosine) = (k as f64 * phase).sin_cos();
        turned.cosines.push(a * cosine + b * sine);
        turned.sines.push(b * cosine - a * sine);
    }
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

/// The inverse of the derivative on the block, in doubles.
fn inverse(certificate: &CycleCertificate) -> Result<Vec<Vec<crate::exact::Integer>>, NotProved> {
    let rows = derivative_of_block(certificate)?;
    inverted(DMatrix::from_fn(rows.len(), rows.len(), |row, column| {
        rows[row][column]
    }))
}

/// Newton's iteration with one inverse.
fn refine(certificate: &mut CycleCertificate) -> Result<(), NotProved> {
    let bits = certificate.bits;
    certificate.inverse = inverse(certificate)?;
    iterate(certificate, few_units(bits), correction, |certificate, step| {
        let short = |ball| Balls { bits }.converted(ball, WORKING).middle;
        certificate.reciprocal -= short(&step.block[0]);
        let block = certificate.block();
        let corrections = block[1..].iter().zip(&step.block[1..]);
        for (wave, ball) in corrections.chain(step.beyond.iter().map(|(wave, ball)| (wave, ball))) {
            match *wave {
                Wave::Cosine(k) => subtract(&mut certificate.cosines, k, short(ball)),
                Wave::Sine(k) => subtract(&mut certificate.sines, k, short(ball)),
            }
        }
        shorten(&mut certificate.cosines);
        shorten(&mut certificate.sines);
    })
}

/// Checks a certificate with its block, and claims what is proved.
fn proved(certificate: &mut CycleCertificate) -> Result<Certified, NotProved> {
    certificate.inverse = inverse(certificate)?;
    certificate.sigma = weight(&certificate.inverse);
    let proof = prove(certificate)?;
    [_, certificate.claim] = claimed(proof.radius.value());
    let certified = certificate.certified(proof)?;
    claim_errors(certificate.formula.as_mut(), &certified);
    Ok(certified)
}

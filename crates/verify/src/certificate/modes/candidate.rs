//! The numbers of a certificate of a mode: Newton's iteration from the motion that the judge of modes
//! found by shooting. The theorem trusts nothing here.

use std::collections::BTreeMap;

use num_traits::Zero as _;

use super::super::candidate::{
    BITS, INVERSE_BITS, NOISE, NotCertified, claim_errors, claimed, few_units, first_proof,
    inverse, is_near, iterate, not_proved, odd_below, subtract_step, units, weight, without_claims,
    written_out,
};
use super::super::force::is_odd;
use super::super::formula::{JudgedFormula, LettersOfLaw};
use super::super::fourier_series::WORKING;
use super::super::radii_polynomial::NotProved;
use super::super::theorem::{correction, prove};
use super::super::{Certified, HIGHEST_HARMONIC, ModeBranch, law};
use super::{ModeAmplitude, ModeCertificate, last_harmonic_of_largest_block};
use crate::decimal::rounded_to;
use crate::exact::ball::Balls;
use crate::exact::rational::to_f64;
use crate::exact::{Integer, Polynomial, Rational};
use crate::expr::{Expr, ExprError};
use crate::interrupt::Interrupt;
use crate::method::numbers::NoNumbers;
use crate::modes::{FreeSystem, NonlinearMode};
use crate::numeric::harmonics::Transform;
use crate::solution::AmplitudeConvention;
use crate::symbol::Symbol;
use crate::symbol::letters::FREQUENCY;
use crate::values::Values;
use crate::verify::{JudgedMode, judge_mode};

/// A certificate of the motion that the formulas of a mode are about, and what it proves of them.
///
/// # Errors
/// [`NotCertified`].
pub fn certify_mode(
    system: &FreeSystem,
    mode: &NonlinearMode,
    at: &Values,
) -> Result<(ModeCertificate, Certified), NotCertified> {
    certified_mode(system, mode, at, true)
}

/// A certificate of the motion that the formulas of a mode are about, without the formulas: the law
/// may have no value there.
///
/// # Errors
/// [`NotCertified`].
pub fn certify_mode_motion(
    system: &FreeSystem,
    mode: &NonlinearMode,
    at: &Values,
) -> Result<(ModeCertificate, Certified), NotCertified> {
    certified_mode(system, mode, at, false)
}

fn certified_mode(
    system: &FreeSystem,
    mode: &NonlinearMode,
    at: &Values,
    with_formula: bool,
) -> Result<(ModeCertificate, Certified), NotCertified> {
    /// The judge's verdict is not used.
    const ANY_TOLERANCE: f64 = 1.0;
    let _letters = system.letters.in_force();
    let judged = judge_mode(system, mode, at, ANY_TOLERANCE, Interrupt::default())?;
    let symbol = mode.amplitude.symbol();
    let (amplitude, values) = at.split(&[symbol]);
    let given = amplitude.into_values().next().unwrap_or_else(Expr::zero);
    let amplitude = given.as_number().ok_or_else(|| NotCertified::Amplitude {
        symbol: symbol.to_string(),
        value: given.to_string(),
    })?;
    let values: BTreeMap<Symbol, Expr> =
        values.iter().map(|(name, value)| (name, value.clone())).collect();
    let (coordinates, forces) = equations(system, &values, true)?;
    let mut odd = true;
    for force in &forces {
        odd &= is_odd(force, &coordinates)?;
    }
    let (coefficients, odd) = harmonics(&judged, odd);
    let measure = measure(mode, &values)?;
    let formula = match with_formula {
        true => Some(formula(mode, &judged, at)?),
        false => None,
    };
    let seen = coefficients.iter().map(Vec::len).max().unwrap_or(0);
    let most = last_harmonic_of_largest_block(coordinates.len(), odd);
    let mut certificate = ModeCertificate {
        coordinates,
        forces,
        measure,
        amplitude: amplitude.clone(),
        odd,
        bits: BITS,
        mu: units(judged.true_frequency.powi(-2), BITS),
        coefficients,
        highest: odd_below((2 * seen).max(15), most),
        inverse_bits: INVERSE_BITS,
        inverse: vec![],
        sigma: 0,
        claim: Rational::zero(),
        formula,
    };
    certificate.well_formed_formula().map_err(NotCertified::Formula)?;
    let unknowns = |certificate: &ModeCertificate| certificate.problem().block().len();
    refine(&mut certificate).map_err(|reason| not_proved(reason, unknowns(&certificate)))?;
    let count = certificate.coordinates.len();
    let largest = |odd| last_harmonic_of_largest_block(count, odd);
    let found = first_proof(odd, seen, largest, |block| {
        (certificate.highest, certificate.odd) = (block.highest, block.odd);
        proved(&mut certificate)
    });
    match found {
        Ok(certified) => Ok((certificate, certified)),
        Err(reason) => Err(not_proved(reason, unknowns(&certificate))),
    }
}

/// The branch of a mode on a range of amplitudes that begins at this one, of a system with numbers for all
/// parameters.
///
/// # Errors
/// [`NotCertified`].
pub(in super::super) fn mode_branch(
    system: &FreeSystem,
    mode: &NonlinearMode,
    from: &Rational,
) -> Result<ModeBranch, NotCertified> {
    /// Digits of the motion that names the branch.
    const DIGITS: usize = 12;
    const ANY_TOLERANCE: f64 = 1.0;
    let _letters = system.letters.in_force();
    let nothing = BTreeMap::new();
    let (coordinates, forces) = equations(system, &nothing, false)?;
    let measure = measure(mode, &nothing)?;
    let rounded = |value: f64| rounded_to(value, DIGITS);
    if from.is_zero() {
        // The linear mode.
        let number = |polynomial: &Polynomial| {
            let value = law::number(&with_numbers(mode, polynomial, &nothing)?);
            let value = value.ok_or(NotCertified::Motion(NoNumbers::NotReal))?;
            Ok::<f64, NotCertified>(WORKING.nearest(&value))
        };
        let shape = mode.linear.shape.iter().map(number).collect::<Result<Vec<f64>, _>>()?;
        let size = match &measure {
            ModeAmplitude::Start(coordinate) => shape.get(*coordinate).copied().unwrap_or(1.0),
            ModeAmplitude::FirstHarmonic(factors) => {
                let parts = factors.iter().zip(&shape).filter_map(|(factor, part)| {
                    Some(WORKING.nearest(&law::number(factor)?) * part)
                });
                parts.sum()
            }
        };
        let list = |part: &f64| vec![Rational::zero(), rounded(part / size)];
        let coefficients = shape.iter().map(list).collect();
        let mu = rounded(number(&mode.linear.square)?.recip());
        return Ok(ModeBranch { coordinates, forces, measure, mu, coefficients });
    }
    let mut at = Values::default();
    // A number is a value, and the name is given once.
    let _ = at.insert(mode.amplitude.symbol(), Expr::number(from.clone()));
    let judged = judge_mode(system, mode, &at, ANY_TOLERANCE, Interrupt::default())?;
    let mut odd = true;
    for force in &forces {
        odd &= is_odd(force, &coordinates)?;
    }
    let (coefficients, _) = harmonics(&judged, odd);
    let size = to_f64(from);
    let balls = Balls { bits: BITS };
    let number = |units: &Integer| rounded(balls.nearest(&balls.dyadic(units, BITS)) / size);
    let coefficients = coefficients.iter().map(|list| list.iter().map(number).collect()).collect();
    let mu = rounded(judged.true_frequency.powi(-2));
    Ok(ModeBranch { coordinates, forces, measure, mu, coefficients })
}

/// The definition of the amplitude of a mode, with these values in it.
fn measure(
    mode: &NonlinearMode,
    values: &BTreeMap<Symbol, Expr>,
) -> Result<ModeAmplitude, ExprError> {
    Ok(match mode.amplitude {
        AmplitudeConvention::Initial => ModeAmplitude::Start(mode.along),
        AmplitudeConvention::FirstHarmonic => {
            let factors = mode.linear.modal.iter();
            let factors = factors.map(|factor| with_numbers(mode, factor, values));
            ModeAmplitude::FirstHarmonic(factors.collect::<Result<_, ExprError>>()?)
        }
    })
}

/// The coordinates, and f of `q'' + f(q) = 0` with numbers: the accelerations by the equations, for
/// which the mass matrix was inverted exactly; polynomials written out, or as they were given.
fn equations(
    system: &FreeSystem,
    values: &BTreeMap<Symbol, Expr>,
    is_written_out: bool,
) -> Result<(Vec<Symbol>, Vec<Expr>), NotCertified> {
    let names = &system.equations.coordinates;
    let coordinates: Vec<Symbol> = names.iter().map(|name| Symbol::new(name.written())).collect();
    let renamed: BTreeMap<Symbol, Expr> =
        names.iter().copied().zip(coordinates.iter().map(|name| Expr::from(*name))).collect();
    let rates = &system.equations.rates;
    let force = |name: &Symbol| {
        let velocity = name.derivative();
        let place = rates.states.iter().position(|state| *state == velocity);
        let rate = place.and_then(|place| rates.right.get(place)).cloned();
        let force = -rate.unwrap_or_else(Expr::zero).substitute_all(values)?;
        let moves = |force: &Expr| names.iter().any(|name| force.contains(name.derivative()));
        let force = match is_written_out || moves(&force) {
            true => written_out(force, names)?,
            false => force,
        };
        if moves(&force) {
            return Err(NotCertified::NotOfPosition {
                coordinate: name.to_string(),
                force: force.to_string(),
            });
        }
        Ok(force.substitute_all(&renamed)?)
    };
    let forces = names.iter().map(force).collect::<Result<_, NotCertified>>()?;
    Ok((coordinates, forces))
}

/// The cosine coefficients of each coordinate of the true motion, and whether those of even
/// harmonics are zero, where they may be.
fn harmonics(judged: &JudgedMode, may_be_odd: bool) -> (Vec<Vec<Integer>>, bool) {
    let [_, path] = &judged.paths;
    let half = path.len() - 1;
    let transform = Transform::new(2 * half);
    let of_coordinate = |coordinate: usize| {
        // The second half of the period is the first one backwards.
        let place = |index: usize| path[index.min(2 * half - index)][coordinate];
        let places: Vec<f64> = (0..2 * half).map(place).collect();
        let mut cosines = transform.harmonics(&places, (half - 1).min(HIGHEST_HARMONIC)).cosines;
        // The coefficient of the constant was twice the mean.
        cosines[0] /= 2.0;
        cosines
    };
    let mut all: Vec<Vec<f64>> = (0..path[0].len()).map(of_coordinate).collect();
    let largest = all.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
    let mut even = all.iter().flat_map(|cosines| cosines.iter().step_by(2));
    let odd = may_be_odd && even.all(|value| value.abs() < 1e3 * NOISE * largest);
    for cosines in &mut all {
        if odd {
            cosines.iter_mut().step_by(2).for_each(|value| *value = 0.0);
        }
        while cosines.len() > 2 && cosines.last().is_some_and(|last| last.abs() < NOISE * largest) {
            cosines.pop();
        }
    }
    let in_units = |cosines: Vec<f64>| cosines.iter().map(|value| units(*value, BITS)).collect();
    (all.into_iter().map(in_units).collect(), odd)
}

/// A polynomial of a mode with its definitions and these values in it.
fn with_numbers(
    mode: &NonlinearMode,
    polynomial: &Polynomial,
    values: &BTreeMap<Symbol, Expr>,
) -> Result<Expr, ExprError> {
    let mut value = Expr::from(polynomial);
    for definition in mode.definitions.iter().rev() {
        value = value.substitute(definition.symbol, &definition.meaning)?;
    }
    value.substitute_all(values)
}

/// The law and the motions of a mode with their numbers; nothing is claimed yet.
fn formula(
    mode: &NonlinearMode,
    judged: &JudgedMode,
    at: &Values,
) -> Result<JudgedFormula, NotCertified> {
    let frequency = judged.frequency.ok_or(NotCertified::Motion(NoNumbers::NotReal))?;
    let values: BTreeMap<Symbol, Expr> =
        at.iter().map(|(name, value)| (name, value.clone())).collect();
    let mut formula = without_claims([&[], &[]], BITS);
    formula.letters = LettersOfLaw {
        amplitude: Symbol::new(mode.amplitude.symbol().written()),
        ..LettersOfLaw::in_force()
    };
    formula.law = law_of(mode);
    formula.values = law::values_in(&formula.law, at);
    formula.frequency = units(frequency, BITS);
    match law::frequency(&formula) {
        Some(exact) if is_near(&exact, frequency) => {
            formula.frequency = Balls { bits: BITS }.converted(&exact, WORKING).middle;
        }
        _ => formula.law = mode.formula(),
    }
    let mut motions = vec![];
    for series in &mode.motion {
        let mut list = vec![];
        for harmonic in 0..=series.highest_harmonic() {
            let value = with_numbers(mode, &series.cosine(harmonic).mean().0, &values)?;
            let ball = law::number(&value).ok_or(NotCertified::Motion(NoNumbers::NotReal))?;
            list.push(Balls { bits: BITS }.converted(&ball, WORKING).middle);
        }
        motions.push(list);
    }
    let mut motions = motions.into_iter();
    formula.coefficients = motions.next().unwrap_or_default();
    formula.others = motions.collect();
    Ok(formula)
}

/// The law of a mode as text, with the definitions that it needs.
fn law_of(mode: &NonlinearMode) -> String {
    let value = Expr::from(&mode.frequency_squared);
    let mut names: Vec<Symbol> = value.symbols().into_iter().collect();
    let mut needed = vec![];
    for definition in mode.definitions.iter().rev() {
        if names.contains(&definition.symbol) {
            names.extend(definition.meaning.symbols());
            needed.push(format!(", {} = {}", definition.symbol, definition.meaning));
        }
    }
    needed.reverse();
    format!("{FREQUENCY}^2 = {value}{}", needed.concat())
}

/// Newton's iteration with one inverse.
fn refine(certificate: &mut ModeCertificate) -> Result<(), NotProved> {
    let bits = certificate.bits;
    certificate.inverse = inverse(&certificate.problem())?;
    let step = |certificate: &ModeCertificate| correction(certificate.problem());
    iterate(certificate, few_units(bits), step, |certificate, step| {
        let block = certificate.problem().block();
        let mut lists: Vec<&mut Vec<Integer>> = certificate.coefficients.iter_mut().collect();
        subtract_step(&mut certificate.mu, &mut lists, &block, bits, step);
    })
}

/// Checks a certificate with its block, and enters the proved values as claims.
fn proved(certificate: &mut ModeCertificate) -> Result<Certified, NotProved> {
    certificate.inverse = inverse(&certificate.problem())?;
    certificate.sigma = weight(&certificate.inverse);
    let proof = prove(certificate.problem())?;
    [_, certificate.claim] = claimed(proof.radius.value());
    let certified = certificate.certified(proof)?;
    claim_errors(certificate.formula.as_mut(), &certified);
    Ok(certified)
}

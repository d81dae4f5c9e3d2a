//! The numbers of a certificate of driven coordinates: Newton's iteration from the motion that the
//! motion from rest comes to, by Runge-Kutta. The theorem trusts nothing here.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::DMatrix;
use num_traits::Zero as _;

use super::super::super::candidate::{
    BITS, INVERSE_BITS, NOISE, NotCertified, claimed, few_units, first_proof, inverted, iterate,
    not_proved, odd_below, shorten, subtract, units, written_out,
};
use super::super::super::fourier_series::{BasisFunction, WORKING};
use super::super::super::radii_polynomial::NotProved;
use super::super::super::{Certified, HIGHEST_HARMONIC};
use super::super::Drive;
use super::super::candidate::is_linear_in;
use super::super::theorem::{correction, derivative_of_block, prove, waves_of_drive};
use super::super::waves::{common_frequency, in_waves};
use super::{CoupledCertificate, last_harmonic_of_largest_block};
use crate::coupled::CoupledEquations;
use crate::exact::ball::Balls;
use crate::exact::rational::to_f64;
use crate::exact::{Integer, Rational};
use crate::expr::{CompiledList, Expr};
use crate::numeric::harmonics::{Harmonics, Transform};
use crate::numeric::ode::{IntegrationOptions, Point, end_values};
use crate::symbol::Symbol;
use crate::values::Values;

/// A certificate of a steady motion of driven coordinates, that to which the motion from rest at the
/// origin comes; no formula is judged.
///
/// # Errors
/// [`NotCertified`].
pub fn certify_coupled(
    equations: &CoupledEquations,
    at: &Values,
) -> Result<(CoupledCertificate, Certified), NotCertified> {
    let (values, others) = at.split(&equations.parameters);
    if let Some((name, _)) = others.iter().next() {
        return Err(NotCertified::NoParameter(name.to_string()));
    }
    let missing = equations.parameters.iter().find(|name| !values.contains_key(name));
    if let Some(name) = missing {
        return Err(NotCertified::NoValueOf(name.to_string()));
    }
    let rates: Vec<Expr> = equations
        .rates
        .right
        .iter()
        .map(|rate| rate.substitute_all(&values))
        .collect::<Result<_, _>>()?;
    let frequency = common_frequency(&rates, Symbol::new("t"))?;
    let (damping, forces) = parts(equations, &rates, &frequency)?;
    let names = equations.coordinates.iter();
    let coordinates: Vec<Symbol> = names.map(|name| Symbol::new(name.written())).collect();
    let count = coordinates.len();
    let mut certificate = CoupledCertificate {
        coordinates,
        damping,
        forces,
        drive: Drive { frequency: frequency.clone(), periods: 1, harmonic: 1 },
        odd: false,
        bits: BITS,
        cosines: vec![],
        sines: vec![],
        highest: 1,
        inverse_bits: INVERSE_BITS,
        inverse: vec![],
        claim: Rational::zero(),
    };
    if !certificate.problem().has_potential_damping()? {
        return Err(NotCertified::DampingOfNoFunction);
    }
    let truth = harmonics(&settled(equations, &rates, to_f64(&frequency))?);
    let lists = || truth.iter().flat_map(|own| [&own.cosines, &own.sines]);
    let seen = lists().map(Vec::len).max().unwrap_or(0);
    if seen >= HIGHEST_HARMONIC / 2 {
        return Err(NotCertified::TooManyHarmonics(HIGHEST_HARMONIC / 2));
    }
    let in_units = |list: &Vec<f64>| list.iter().map(|value| units(*value, BITS)).collect();
    certificate.cosines = truth.iter().map(|own| in_units(&own.cosines)).collect();
    certificate.sines = truth.iter().map(|own| in_units(&own.sines)).collect();
    let largest = lists().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
    let mut even = lists().flat_map(|list| list.iter().step_by(2));
    let odd = even.all(|value| value.abs() < 1e3 * NOISE * largest) && certificate.is_odd()?;
    if odd {
        for list in certificate.cosines.iter_mut().chain(&mut certificate.sines) {
            list.iter_mut().step_by(2).for_each(|even| *even = Integer::zero());
        }
    }
    certificate.odd = odd;
    let most = last_harmonic_of_largest_block(count, odd);
    certificate.highest = odd_below((3 * seen / 2).max(15), most);
    let unknowns = |certificate: &CoupledCertificate| certificate.problem().block().len();
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

/// G and h of `q'' + G(q) q' + h(q, cos(Omega t), sin(Omega t)) = 0`, from the accelerations with
/// numbers, for which the mass matrix was inverted exactly.
fn parts(
    equations: &CoupledEquations,
    rates: &[Expr],
    frequency: &Rational,
) -> Result<(Vec<Vec<Expr>>, Vec<Expr>), NotCertified> {
    let (time, names) = (Symbol::new("t"), &equations.coordinates);
    let velocities: Vec<Symbol> = names.iter().map(|name| name.derivative()).collect();
    let at_rest: BTreeMap<Symbol, Expr> =
        velocities.iter().map(|velocity| (*velocity, Expr::zero())).collect();
    let written: Vec<Symbol> = names.iter().map(|name| Symbol::new(name.written())).collect();
    if let Some(name) = written.iter().find(|name| waves_of_drive().contains(name)) {
        return Err(NotCertified::WaveAsCoordinate(name.to_string()));
    }
    let renamed: BTreeMap<Symbol, Expr> =
        names.iter().copied().zip(written.iter().map(|name| Expr::from(*name))).collect();
    let (mut damping, mut forces) = (vec![], vec![]);
    for (name, velocity) in names.iter().zip(&velocities) {
        let place = equations.rates.states.iter().position(|state| state == velocity);
        let Some(rate) = place.and_then(|place| rates.get(place)) else {
            return Err(NotCertified::FirstOrder(name.to_string()));
        };
        let force = written_out(-rate.clone(), &equations.rates.states)?;
        for term in force.terms() {
            for velocity in &velocities {
                let slope = term.differentiate(*velocity)?;
                let others = velocities.iter().chain([&time]);
                if !is_linear_in(term, *velocity)?
                    || others.into_iter().any(|name| slope.contains(*name))
                {
                    return Err(NotCertified::NotCoupledDriven {
                        coordinate: name.to_string(),
                        term: term.to_string(),
                    });
                }
            }
        }
        let own = velocities.iter().map(|velocity| {
            let entry = force.differentiate(*velocity)?;
            Ok(written_out(entry, names)?.substitute_all(&renamed)?)
        });
        damping.push(own.collect::<Result<Vec<Expr>, NotCertified>>()?);
        let rest = force.substitute_all(&at_rest)?.substitute_all(&renamed)?;
        let rest = in_waves(&rest, time, frequency)?;
        if rest.contains(time) {
            return Err(NotCertified::NotCoupledDriven {
                coordinate: name.to_string(),
                term: rest.to_string(),
            });
        }
        forces.push(rest);
    }
    Ok((damping, forces))
}

/// The places of all coordinates at equal steps of one period of the drive, from a multiple of the
/// period on, of the motion that begins at rest at the origin.
fn settled(
    equations: &CoupledEquations,
    rates: &[Expr],
    frequency: f64,
) -> Result<Vec<Vec<f64>>, NotCertified> {
    /// The largest number of periods.
    const PERIODS: usize = 400;
    /// Change over a period, beside the largest state, below which a motion has settled, and below
    /// which it is taken at the end for one that settles.
    const SETTLED: [f64; 2] = [1e-9, 1e-4];
    const SAMPLES: usize = 1024;
    let names: Vec<Symbol> =
        equations.rates.states.iter().copied().chain([Symbol::new("t")]).collect();
    let compiled = CompiledList::new(rates, &names).map_err(|_| NotCertified::NotSettled)?;
    let scratch = RefCell::new(vec![]);
    let field = |t: f64, state: &Vec<f64>, rates: &mut Vec<f64>| {
        let arguments: Vec<f64> = state.iter().copied().chain([t]).collect();
        compiled.call(&arguments, &mut scratch.borrow_mut(), rates);
    };
    let options = IntegrationOptions { maximum_steps: 20_000, ..IntegrationOptions::default() };
    let period = TAU / frequency;
    let after = |state: Vec<f64>, part: [f64; 2]| {
        let start = Point { t: period * part[0], y: state };
        end_values(field, start, period * part[1], &options).ok_or(NotCertified::NotSettled)
    };
    let mut state = vec![0.0; equations.rates.states.len()];
    let mut left = f64::INFINITY;
    for _ in 0..PERIODS {
        let next = after(state.clone(), [0.0, 1.0])?;
        let apart = state.iter().zip(&next).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        let size = next.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        (state, left) = (next, apart / size);
        if left < SETTLED[0] {
            break;
        }
    }
    // A quotient that is no number has not settled either.
    if left.is_nan() || left > SETTLED[1] {
        return Err(NotCertified::NotSettled);
    }
    let mut samples = vec![];
    for index in 0..SAMPLES {
        samples.push(state[..equations.coordinates.len()].to_vec());
        let part = |index: usize| index as f64 / SAMPLES as f64;
        state = after(state, [part(index), part(index + 1)])?;
    }
    Ok(samples)
}

/// The harmonics of samples of one period, without trailing ones that have no significant digits
/// beside the largest of all coordinates.
fn harmonics(samples: &[Vec<f64>]) -> Vec<Harmonics> {
    /// The part of the largest harmonic below which those of a motion that is not quite settled have
    /// no digits.
    const ERROR: f64 = 1e-9;
    let transform = Transform::new(samples.len());
    let count = samples.first().map_or(0, Vec::len);
    let of_coordinate = |coordinate: usize| {
        let places: Vec<f64> = samples.iter().map(|places| places[coordinate]).collect();
        let mut found = transform.harmonics(&places, HIGHEST_HARMONIC.min(places.len() / 2));
        // The coefficient of the constant was twice the mean.
        found.cosines[0] /= 2.0;
        found
    };
    let mut all: Vec<Harmonics> = (0..count).map(of_coordinate).collect();
    let sizes = all.iter().flat_map(|own| own.cosines.iter().chain(&own.sines));
    let largest = sizes.fold(0.0_f64, |most, value| most.max(value.abs()));
    for list in all.iter_mut().flat_map(|own| [&mut own.cosines, &mut own.sines]) {
        while list.len() > 2 && list.last().is_some_and(|last| last.abs() <= ERROR * largest) {
            list.pop();
        }
    }
    all
}

/// The inverse of the derivative on the block, in doubles.
fn inverse(certificate: &CoupledCertificate) -> Result<Vec<Vec<Integer>>, NotProved> {
    let rows = derivative_of_block(certificate.problem())?;
    inverted(DMatrix::from_fn(rows.len(), rows.len(), |row, column| rows[row][column]))
}

/// Newton's iteration with one inverse.
fn refine(certificate: &mut CoupledCertificate) -> Result<(), NotProved> {
    let bits = certificate.bits;
    certificate.inverse = inverse(certificate)?;
    let step = |certificate: &CoupledCertificate| correction(certificate.problem());
    iterate(certificate, few_units(bits), step, |certificate, step| {
        let short = |ball| Balls { bits }.converted(ball, WORKING).middle;
        let block = certificate.problem().block();
        let corrections = block.iter().zip(&step.block);
        for (wave, ball) in corrections.chain(step.beyond.iter().map(|(wave, ball)| (wave, ball))) {
            let (list, k) = match wave.function {
                BasisFunction::Cosine(k) => (&mut certificate.cosines[wave.coordinate], k),
                BasisFunction::Sine(k) => (&mut certificate.sines[wave.coordinate], k),
            };
            subtract(list, k, short(ball));
        }
        certificate.cosines.iter_mut().chain(&mut certificate.sines).for_each(shorten);
    })
}

/// Checks a certificate with its block, and enters the proved radius as the claim.
fn proved(certificate: &mut CoupledCertificate) -> Result<Certified, NotProved> {
    certificate.inverse = inverse(certificate)?;
    let proof = prove(certificate.problem())?;
    [_, certificate.claim] = claimed(proof.radius.value());
    certificate.certified(proof)
}

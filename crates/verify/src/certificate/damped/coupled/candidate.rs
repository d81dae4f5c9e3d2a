//! The numbers of a certificate of several coordinates: Newton's iteration from the motion that the
//! motion from rest comes to, or without a drive that from a small start, by Runge-Kutta. The theorem
//! trusts nothing here.

use std::cell::RefCell;
use std::collections::{BTreeMap, VecDeque};
use std::f64::consts::TAU;

use nalgebra::DMatrix;
use num_traits::Zero as _;

use super::super::super::candidate::{
    BITS, INVERSE_BITS, NOISE, NotCertified, claimed, few_units, first_proof, inverted, iterate,
    not_proved, odd_below, shorten, units, weight, written_out,
};
use super::super::super::radii_polynomial::NotProved;
use super::super::super::{Certified, HIGHEST_HARMONIC};
use super::super::candidate::{is_linear_in, phase_of, phase_shifted, subtract_step};
use super::super::problem::waves_of_drive;
use super::super::theorem::{correction, derivative_of_block, prove};
use super::super::waves::{common_frequency, in_waves};
use super::super::{ClaimedStability, Drive};
use super::{CoupledCertificate, last_harmonic_of_largest_block};
use crate::coupled::CoupledEquations;
use crate::exact::rational::to_f64;
use crate::exact::{Integer, Rational};
use crate::expr::{CompiledList, Expr};
use crate::numeric::harmonics::{Harmonics, Transform};
use crate::numeric::ode::{
    Action, Event, IntegrationOptions, Point, StopReason, end_values, integrate_first_order,
};
use crate::symbol::Symbol;
use crate::values::Values;

/// A certificate of a steady motion of several coordinates: with a drive that to which the motion
/// from rest at the origin comes, without one the limit cycle to which the motion from rest at small
/// displacements comes, a tenth, a twentieth and so on. Values of coordinates are another start, at
/// rest too and zero for those that have none. No formula is judged.
///
/// # Errors
/// [`NotCertified`].
pub fn certify_coupled(
    equations: &CoupledEquations,
    at: &Values,
) -> Result<(CoupledCertificate, Certified), NotCertified> {
    let (values, others) = at.split(&equations.parameters);
    let (start, others) = others.split(&equations.coordinates);
    if let Some((name, _)) = others.iter().next() {
        return Err(NotCertified::NoParameter(name.to_string()));
    }
    let start = Displacements::new(start)?;
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
    let time = Symbol::new("t");
    let frequency = match rates.iter().any(|rate| rate.contains(time)) {
        true => Some(common_frequency(&rates, time)?),
        false => None,
    };
    let (damping, forces) = parts(equations, &rates, frequency.as_ref())?;
    let names = equations.coordinates.iter();
    let coordinates: Vec<Symbol> = names.map(|name| Symbol::new(name.written())).collect();
    let count = coordinates.len();
    let mut certificate = CoupledCertificate {
        coordinates,
        damping,
        forces,
        drive: frequency.map(|frequency| Drive { frequency, periods: 1, harmonic: 1 }),
        phase: 0,
        odd: false,
        bits: BITS,
        reciprocal: Integer::zero(),
        cosines: vec![],
        sines: vec![],
        highest: 1,
        inverse_bits: INVERSE_BITS,
        inverse: vec![],
        sigma: 0,
        claim: Rational::zero(),
        stability: None,
    };
    if !certificate.problem().has_potential_damping()? {
        return Err(NotCertified::DampingOfNoFunction);
    }
    let flow = NumericalEquations::new(equations, &rates)?;
    let truth = match &mut certificate.drive {
        Some(drive) => {
            let state = flow.state(&start, &|_| 0.0);
            let DrivenPeriod { periods, samples, change } =
                flow.settled(state, to_f64(&drive.frequency))?;
            let found = harmonics(&samples, change);
            drive.periods = periods;
            // Of a motion of the period of the drive it is the first, of another the largest one.
            if periods > 1 {
                drive.harmonic = largest_harmonic(&found);
            }
            found
        }
        None => {
            let state = flow.state(&start, &|place| 0.1 / (place + 1) as f64);
            let CyclePeriod { period, samples, change } =
                flow.cycle(state).map_err(|reason| reason.of_motion_from(&start))?;
            certificate.reciprocal = units(period / TAU, BITS);
            let found = harmonics(&samples, change);
            certificate.phase = place_of_largest(found.len(), &|place| {
                found[place].cosines[1].hypot(found[place].sines[1])
            });
            let phase = phase_of(&found[certificate.phase]);
            let mut found: Vec<Harmonics> =
                found.iter().map(|own| phase_shifted(own, phase)).collect();
            found[certificate.phase].sines[1] = 0.0;
            found
        }
    };
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
/// numbers, for which the mass matrix was inverted exactly; without a frequency there is no drive.
fn parts(
    equations: &CoupledEquations,
    rates: &[Expr],
    frequency: Option<&Rational>,
) -> Result<(Vec<Vec<Expr>>, Vec<Expr>), NotCertified> {
    let (time, names) = (Symbol::new("t"), &equations.coordinates);
    let velocities: Vec<Symbol> = names.iter().map(|name| name.derivative()).collect();
    let at_rest: BTreeMap<Symbol, Expr> =
        velocities.iter().map(|velocity| (*velocity, Expr::zero())).collect();
    let written: Vec<Symbol> = names.iter().map(|name| Symbol::new(name.written())).collect();
    let mut taken = written.iter().filter(|name| waves_of_drive().contains(name));
    if let Some(name) = taken.next().filter(|_| frequency.is_some()) {
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
        let rest = match frequency {
            Some(frequency) => in_waves(&rest, time, frequency)?,
            None => written_out(rest, &written)?,
        };
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

/// The displacements from which a motion starts at rest, of the coordinates that have one.
struct Displacements(BTreeMap<Symbol, f64>);

impl Displacements {
    fn new(values: BTreeMap<Symbol, Expr>) -> Result<Self, NotCertified> {
        let number = |(name, value): (Symbol, Expr)| match value.evaluate(&BTreeMap::new()) {
            Ok(number) if number.is_finite() => Ok((name, number)),
            _ => Err(NotCertified::StartOfMotion(format!("{name} = {value}"))),
        };
        Ok(Self(values.into_iter().map(number).collect::<Result<_, _>>()?))
    }
}

/// The reason why a motion without drive leads to no limit cycle.
enum NoCycle {
    Rest,
    Away,
    Irregular,
}

impl NoCycle {
    /// The refusal of the motion from this start.
    fn of_motion_from(self, Displacements(start): &Displacements) -> NotCertified {
        let equations: Vec<String> =
            start.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        let from = match equations.is_empty() {
            true => "small displacements, 1/10, 1/20, 1/30 and so on,".to_owned(),
            false => equations.join(", "),
        };
        match self {
            Self::Rest => NotCertified::ComesToRest(from),
            Self::Away => NotCertified::RunsAway(from),
            Self::Irregular => NotCertified::NoCycle(from),
        }
    }
}

/// One period of a limit cycle.
struct CyclePeriod {
    period: f64,
    /// The places of all coordinates at equal steps.
    samples: Vec<Vec<f64>>,
    /// Difference of the states at both ends, as a part of the size of the motion.
    change: f64,
}

/// One period of a driven motion.
struct DrivenPeriod {
    /// The number of periods of the drive in it.
    periods: usize,
    /// The places of all coordinates at equal steps.
    samples: Vec<Vec<f64>>,
    /// Difference of the states at both ends, as a part of the largest value.
    change: f64,
}

/// The largest number of periods of the drive in one of the motion that is looked for.
const MOST_PERIODS: usize = 6;

/// Number of samples of a period.
const SAMPLES: usize = 1024;

/// Change over a period, beside the size of the motion, below which a motion has settled, and below
/// which it is taken at the end for one that settles.
const SETTLED: [f64; 2] = [1e-9, 1e-4];

/// The equations in doubles.
struct NumericalEquations {
    rates: CompiledList,
    coordinates: Vec<Symbol>,
    /// The number of states.
    states: usize,
    /// The places of the velocities among the states, of which the coordinates are the first.
    velocities: Vec<usize>,
    scratch: RefCell<Vec<f64>>,
}

impl NumericalEquations {
    fn new(equations: &CoupledEquations, rates: &[Expr]) -> Result<Self, NotCertified> {
        let states = &equations.rates.states;
        let names: Vec<Symbol> = states.iter().copied().chain([Symbol::new("t")]).collect();
        let place = |name: &Symbol| {
            let velocity = name.derivative();
            let place = states.iter().position(|state| *state == velocity);
            place.ok_or_else(|| NotCertified::FirstOrder(name.to_string()))
        };
        Ok(Self {
            rates: CompiledList::new(rates, &names).map_err(|_| NotCertified::NotSettled)?,
            coordinates: equations.coordinates.clone(),
            states: states.len(),
            velocities: equations.coordinates.iter().map(place).collect::<Result<_, _>>()?,
            scratch: RefCell::new(vec![]),
        })
    }

    /// The rates of a state.
    fn rates(&self, t: f64, state: &[f64], rates: &mut [f64]) {
        let arguments: Vec<f64> = state.iter().copied().chain([t]).collect();
        self.rates.call(&arguments, &mut self.scratch.borrow_mut(), rates);
    }

    /// The state at rest at a start; where it has no value, at another displacement by place.
    fn state(
        &self,
        Displacements(start): &Displacements,
        otherwise: &dyn Fn(usize) -> f64,
    ) -> Vec<f64> {
        let places =
            self.coordinates.iter().enumerate().map(|(place, name)| match start.get(name) {
                None if start.is_empty() => otherwise(place),
                value => value.copied().unwrap_or(0.0),
            });
        let mut state: Vec<f64> = places.collect();
        state.resize(self.states, 0.0);
        state
    }

    /// The motion to which that from a state at t = 0 comes, over its period of some periods of the
    /// drive, from a multiple of that on.
    fn settled(&self, mut state: Vec<f64>, frequency: f64) -> Result<DrivenPeriod, NotCertified> {
        /// The largest number of periods.
        const PERIODS: usize = 1000;
        let field = |t: f64, state: &Vec<f64>, rates: &mut Vec<f64>| self.rates(t, state, rates);
        let options = IntegrationOptions { maximum_steps: 20_000, ..IntegrationOptions::default() };
        let period = TAU / frequency;
        let after = |state: Vec<f64>, part: [f64; 2]| {
            let start = Point { t: period * part[0], y: state };
            end_values(field, start, period * part[1], &options).ok_or(NotCertified::NotSettled)
        };
        // The last states, the latest first, and the least number of periods after which the last of
        // them is nearly there again.
        let mut before = VecDeque::new();
        let mut found = None;
        for _ in 0..PERIODS {
            let next = after(state.clone(), [0.0, 1.0])?;
            before.push_front(state);
            before.truncate(MOST_PERIODS);
            let size = largest_of(&next);
            // Rest does not change, and has no size.
            let change = |other: &Vec<f64>| match distance(other, &next) {
                0.0 => 0.0,
                apart => apart / size,
            };
            // A quotient that is no number has not settled either.
            let changes = before.iter().map(change).enumerate();
            found = { changes }.find(|(_, change)| *change <= SETTLED[1]);
            state = next;
            if found.is_some_and(|(_, change)| change < SETTLED[0]) {
                break;
            }
        }
        let Some((less, change)) = found else {
            return Err(NotCertified::NotSettled);
        };
        let periods = less + 1;
        let mut samples = vec![];
        for index in 0..SAMPLES {
            samples.push(state[..self.velocities.len()].to_vec());
            let part = |index: usize| (index * periods) as f64 / SAMPLES as f64;
            state = after(state, [part(index), part(index + 1)])?;
        }
        Ok(DrivenPeriod { periods, samples, change })
    }

    /// One period of the limit cycle to which the motion from a state comes. It is seen where the
    /// coordinate that moves most is highest: the state there comes back.
    fn cycle(&self, mut state: Vec<f64>) -> Result<CyclePeriod, NoCycle> {
        /// The largest number of pieces of the motion, each of so many steps.
        const PIECES: usize = 100;
        const STEPS: usize = 1000;
        /// A duration that no piece has.
        const LONG: f64 = 1e9;
        /// The largest number of turns of the coordinate in a period.
        const TURNS: usize = 12;
        /// Multiples of the first displacement, or of a tenth if that is larger, below which a motion
        /// has come to rest, and beyond which it runs away.
        const REST: f64 = 1e-6;
        const AWAY: f64 = 1e7;
        let first = largest_of(&state).max(0.1);
        let options = IntegrationOptions { maximum_steps: STEPS, ..IntegrationOptions::default() };
        let mut travel = 0.0;
        for piece in 1..=PIECES {
            let field =
                |t: f64, state: &Vec<f64>, rates: &mut Vec<f64>| self.rates(t, state, rates);
            let turn = |velocity: &usize| {
                let velocity = *velocity;
                Event::new(move |point: &Point<Vec<f64>>| point.y[velocity], Action::Record)
            };
            let events: Vec<_> = self.velocities.iter().map(turn).collect();
            let start = Point { t: 0.0, y: state };
            let path = integrate_first_order(field, start, LONG, &events, &options)
                .map_err(|_| NoCycle::Away)?;
            state = path.end().y;
            let is_followed = matches!(
                path.stop_reason(),
                StopReason::EndReached | StopReason::MaximumSteps { .. }
            );
            let size = largest_of(&state);
            if !is_followed || size.is_nan() || size > AWAY * first {
                return Err(NoCycle::Away);
            }
            // The last states where each coordinate turns, and the coordinate that moves most.
            let turns = |coordinate: usize| {
                let own = path.occurrences().iter().rev();
                own.filter(move |turn| turn.event == coordinate).take(2 * TURNS + 2)
            };
            let extent = |coordinate: usize| {
                let places = turns(coordinate).map(|turn| turn.state.y[coordinate]);
                let none = [f64::INFINITY, f64::NEG_INFINITY];
                let [low, high] = places.fold(none, |[low, high], x| [low.min(x), high.max(x)]);
                (high - low).max(0.0)
            };
            let most = place_of_largest(self.coordinates.len(), &extent);
            travel = extent(most);
            let mut highest = turns(most).filter(|turn| !turn.rising).map(|turn| &turn.state);
            let Some(last) = highest.next().filter(|_| travel > REST * first) else { continue };
            let speeds = self
                .velocities
                .iter()
                .flat_map(|velocity| turns(most).map(move |turn| turn.state.y[*velocity].abs()));
            let size = speeds.fold(travel, f64::max);
            let enough = size * SETTLED[usize::from(piece == PIECES)];
            if let Some(before) = highest.find(|before| distance(&before.y, &last.y) < enough) {
                let period = last.t - before.t;
                let change = distance(&before.y, &last.y) / size;
                let sample = |index: usize| {
                    let state = path.state_at(before.t + period * index as f64 / SAMPLES as f64)?;
                    Some(state.y[..self.coordinates.len()].to_vec())
                };
                let samples: Option<_> = (0..SAMPLES).map(sample).collect();
                let samples = samples.ok_or(NoCycle::Irregular)?;
                return Ok(CyclePeriod { period, samples, change });
            }
        }
        match travel > REST * first {
            true => Err(NoCycle::Irregular),
            false => Err(NoCycle::Rest),
        }
    }
}

/// The largest absolute value of a list; not a number if one of them is none.
fn largest_of(values: &[f64]) -> f64 {
    let larger = |most: f64, value: &f64| match value.is_nan() || value.abs() > most {
        true => value.abs(),
        false => most,
    };
    values.iter().fold(0.0, larger)
}

/// The harmonic that is largest, all coordinates together.
fn largest_harmonic(harmonics: &[Harmonics]) -> usize {
    let entry = |list: &[f64], k: usize| list.get(k).copied().unwrap_or(0.0);
    let size = |k: usize| -> f64 {
        harmonics.iter().map(|own| entry(&own.cosines, k).hypot(entry(&own.sines, k))).sum()
    };
    let last = harmonics.iter().map(|own| own.cosines.len()).max().unwrap_or(0);
    place_of_largest(last.max(2) - 1, &|place| size(place + 1)) + 1
}

/// The first place of those with nearly the largest size.
fn place_of_largest(count: usize, size: &dyn Fn(usize) -> f64) -> usize {
    const NEARLY: f64 = 1.0 - 1e-6;
    let most = (0..count).map(size).fold(0.0, f64::max);
    (0..count).find(|place| size(*place) >= NEARLY * most).unwrap_or(0)
}

/// The largest distance of two lists, entry by entry.
fn distance(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
}

/// The harmonics of samples of one period, without trailing ones that have no significant digits
/// beside the largest of all coordinates: the ends of a motion that is not quite settled differ by a
/// change, beside its size.
fn harmonics(samples: &[Vec<f64>], change: f64) -> Vec<Harmonics> {
    let error = change.max(SETTLED[0]);
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
        while list.len() > 2 && list.last().is_some_and(|last| last.abs() <= error * largest) {
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
        let block = certificate.problem().block();
        let reciprocal = certificate.drive.is_none().then_some(&mut certificate.reciprocal);
        let lists = [&mut certificate.cosines[..], &mut certificate.sines[..]];
        subtract_step(reciprocal, lists, &block, bits, step);
        certificate.cosines.iter_mut().chain(&mut certificate.sines).for_each(shorten);
    })
}

/// Checks a certificate with its block, and enters the proved values as claims.
fn proved(certificate: &mut CoupledCertificate) -> Result<Certified, NotProved> {
    certificate.inverse = inverse(certificate)?;
    if certificate.drive.is_none() {
        certificate.sigma = weight(&certificate.inverse);
    }
    let proof = prove(certificate.problem())?;
    [_, certificate.claim] = claimed(proof.radius.value());
    let certified = certificate.certified(proof)?;
    certificate.stability = certified.stability.as_ref().map(ClaimedStability::of);
    Ok(certified)
}

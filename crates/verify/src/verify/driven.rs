//! Verification of the steady motions of a driven oscillator by true ones: periodic motions of the
//! equation as it was typed, found by shooting.
//!
//! The slow equations give the list of steady motions and the starts of the search; the true
//! motion, its amplitude and its Floquet multipliers come from Runge-Kutta on the original equation
//! alone.
//!
//! ```text
//! relative_error = a_formula / a_true - 1,   a = amplitude of the harmonic q of the period 2 pi p/Omega
//! max_deviation  = max |x_formula(t) - x_true(t)|/max |x_true - x_eq|
//! residual       = rms of x'' + f(t, x, x') along the formula / rms of f
//! slope          = log2(max_deviation at delta / at delta/2), delta before all that is small, the detuning among it
//! ```
//!
//! If two steady motions lead to the same true motion, it is assigned to the nearer one, and
//! preferably to one of the same stability; for the other one the search is repeated away from the
//! known motions, and a result counts if it is nearer to this steady motion than to any other of
//! the same stability.
//!
//! Slow equations of order n are off by `delta^(n+1)`; the amplitude where they balance by
//! `delta^n`, which is the slope to expect. It may be more where a coefficient of the error
//! vanishes.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::largest::largest_over;
use super::orbit::SAMPLES;
use super::slope::slopes_of;
use super::smaller::{is_small_in_amplitude, smaller};
use super::values::checked_numbers;
use super::{Motions, Verdict, Verification, VerificationError};
use crate::exact::rational::from_f64;
use crate::expr::{CompiledFunction, Expr};
use crate::method::numbers::symbol_values;
use crate::numeric::ode::{IntegrationOptions, State, integrate};
use crate::numeric::periodic::{PeriodicOrbit, periodic_motion};
use crate::oscillator::Oscillator;
use crate::solution::response::{SteadyMotions, SteadyState};
use crate::solution::{Response, Solution};
use crate::symbol::Symbol;
use crate::values::Values;

/// A steady motion of the slow equations beside the true one.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedState {
    /// The steady state by the slow equations.
    pub state: SteadyState,
    /// The amplitude of the true motion; `None` if none was found.
    pub true_amplitude: Option<f64>,
    /// Whether the true motion attracts, by its Floquet multipliers.
    pub true_stable: Option<bool>,
    /// `amplitude / true amplitude - 1`; `None` for a motion without a resonant part.
    pub relative_error: Option<f64>,
    /// Largest deviation of the motion over one period, over the largest true displacement.
    pub max_deviation: Option<f64>,
}

/// The largest stable steady motion by the formula and the true one, over one period; `None` if
/// there is no such motion.
pub(super) fn motions(
    oscillator: &Oscillator,
    solution: &Solution,
    response: &Response,
    at: &Values,
) -> Result<Option<Motions>, VerificationError> {
    let question = DrivenComparison::new(oscillator, solution, response, at)?;
    let states = question.states();
    let largest = states.iter().find(|state| state.is_stable()).or(states.first());
    let Some((state, found)) = largest
        .and_then(|state| Some((*state, question.truth.find_near(&question.motion, *state)?)))
    else {
        return Ok(None);
    };
    let times = (0..=SAMPLES).map(|k| question.truth.period * k as f64 / SAMPLES as f64);
    let motion = &question.motion;
    Ok(Some(Motions {
        envelope: None,
        formula: times
            .clone()
            .map(|t| (t, motion.position(t, state), motion.velocity(t, state)))
            .collect(),
        truth: times
            .map(|t| {
                let (x, v) = found.phase_point_at(t);
                (t, x, v)
            })
            .collect(),
    }))
}

/// A driven oscillator with numbers.
struct DrivenComparison<'a> {
    solution: &'a Solution,
    numbers: BTreeMap<Symbol, f64>,
    /// omega of the resonant part of the motion.
    frequency: f64,
    truth: Truth,
    motion: SteadyFormula,
}

impl<'a> DrivenComparison<'a> {
    fn new(
        oscillator: &Oscillator,
        solution: &'a Solution,
        response: &Response,
        at: &Values,
    ) -> Result<Self, VerificationError> {
        let mut numbers = checked_numbers(solution, at)?;
        numbers.remove(&solution.amplitude.symbol());
        Self::of_numbers(oscillator, solution, response, numbers)
    }

    fn of_numbers(
        oscillator: &Oscillator,
        solution: &'a Solution,
        response: &Response,
        numbers: BTreeMap<Symbol, f64>,
    ) -> Result<Self, VerificationError> {
        let resonance = solution.modulation.as_ref().and_then(|slow| slow.resonance.as_ref());
        let (p, q) =
            resonance.map_or((1, 1), |resonance| (resonance.times_linear, resonance.times_driving));
        let driving = resonance
            .map_or(Ok(1.0), |resonance| resonance.driving_frequency.evaluate(&numbers))?;
        let period = TAU * f64::from(p) / driving.abs();
        Ok(Self {
            solution,
            frequency: driving.abs() * f64::from(q) / f64::from(p),
            truth: Truth::new(oscillator, &numbers, period, [p, q])?,
            motion: SteadyFormula::new(solution, response, &numbers)?,
            numbers,
        })
    }

    fn states(&self) -> Vec<SteadyState> {
        self.steady_motions().states
    }

    fn steady_motions(&self) -> SteadyMotions {
        self.solution.steady_motions(&|name| self.numbers.get(&name).copied())
    }

    /// Root mean square residual of the formula in the equation, over that of the force.
    fn residual(&self, state: SteadyState) -> Option<f64> {
        let times = (0..SAMPLES).map(|k| self.truth.period * k as f64 / SAMPLES as f64);
        let (mut defects, mut forces) = (0.0, 0.0);
        for t in times {
            let place = [t, self.motion.position(t, state), self.motion.velocity(t, state)];
            let force = self.truth.force.call(&place);
            defects += (self.motion.acceleration(t, state) + force).powi(2);
            forces += force.powi(2);
        }
        Some((defects / forces).sqrt()).filter(|value: &f64| value.is_finite())
    }

    /// Every steady motion with its true one. If two lead to the same true motion, it is assigned
    /// to the one of the same stability, or else to the nearer one. Steady motions at an amplitude
    /// at which the series does not converge are kept only if a true motion is near; the number of
    /// the others is returned.
    fn judged_states(&self) -> (Vec<JudgedState>, usize) {
        /// Largest relative error of the true amplitude.
        const NEAR: f64 = 0.3;
        let SteadyMotions { states, spurious } = self.steady_motions();
        let (count, states) = (states.len(), [states, spurious].concat());
        let is_held = |state: &SteadyState| {
            state.amplitude == 0.0 && self.truth.is_held(self.motion.equilibrium)
        };
        let found: Vec<Option<PeriodicOrbit>> = states
            .iter()
            .enumerate()
            .map(|(k, state)| match (is_held(state), k < count) {
                (true, _) => None,
                (false, true) => self.truth.as_stable(&self.motion, *state),
                (false, false) => self.truth.by_newton(&self.motion, *state, &[]),
            })
            .collect();
        let judge = |state: &SteadyState, found: Option<&PeriodicOrbit>| match is_held(state) {
            true => held_state(*state),
            false => self.truth.compare(&self.motion, *state, found),
        };
        let judged: Vec<JudgedState> =
            states.iter().zip(&found).map(|(state, found)| judge(state, found.as_ref())).collect();
        let same = |one: usize, other: usize| {
            let size = self.motion.size(self.truth.period, states[one]);
            let (Some((x, v)), Some((y, w))) = (start_of(&found[one]), start_of(&found[other]))
            else {
                return false;
            };
            (x - y).abs() < 1e-6 * size && (v - w).abs() < 1e-6 * size * self.frequency
        };
        let apart = |judged: &JudgedState| {
            let other_kind = judged.true_stable != Some(judged.state.is_stable());
            judged.max_deviation.map(|deviation| (other_kind, deviation))
        };
        let nearer = |one: usize, other: usize| {
            let [own, rival] = [one, other].map(|k| apart(&judged[k]));
            rival < own || rival == own && other < one
        };
        let lost = |k: usize| {
            (0..states.len()).any(|other| other != k && same(k, other) && nearer(k, other))
        };
        let mut known: Vec<[f64; 2]> = (0..states.len())
            .filter(|k| !lost(*k))
            .filter_map(|k| found[k].as_ref())
            .flat_map(|found| self.truth.initial_states(found))
            .collect();
        let mut another = |state: &SteadyState| {
            let found = self.truth.find_another(&self.motion, *state, &known)?;
            let judged = judge(state, Some(&found));
            let own = apart(&judged)?;
            let others = states.iter().map(|other| judge(other, Some(&found)));
            if others.filter_map(|other| apart(&other)).any(|other| other < own) {
                return None;
            }
            known.extend(self.truth.initial_states(&found));
            Some(judged)
        };
        let mut all: Vec<JudgedState> = (0..states.len())
            .map(|k| match (lost(k), &found[k]) {
                (false, Some(_)) => judged[k].clone(),
                _ if is_held(&states[k]) => judged[k].clone(),
                _ if k >= count => judge(&states[k], None),
                _ => another(&states[k]).unwrap_or_else(|| judge(&states[k], None)),
            })
            .collect();
        let is_near =
            |judged: &JudgedState| judged.relative_error.is_some_and(|error| error.abs() <= NEAR);
        let doubtful = all.split_off(count);
        let (kept, left_out): (Vec<JudgedState>, Vec<JudgedState>) =
            doubtful.into_iter().partition(is_near);
        if !kept.is_empty() {
            all.extend(kept);
            all.sort_by(|one, other| other.state.amplitude.total_cmp(&one.state.amplitude));
        }
        (all, left_out.len())
    }
}

/// Position and velocity at the start of a true motion.
fn start_of(found: &Option<PeriodicOrbit>) -> Option<(f64, f64)> {
    found.as_ref().map(|found| found.phase_point_at(0.0))
}

/// The exponent of the error: all small quantities are halved repeatedly, and the deviation of the
/// same steady motion is measured.
fn slope(
    oscillator: &Oscillator,
    question: &DrivenComparison,
    judged: &JudgedState,
) -> Option<f64> {
    const HALVINGS: i32 = 3;
    /// The true motion is accurate to 1e-10, and a deviation a hundred times larger is measured to
    /// one per cent.
    const FLOOR: f64 = 1e-8;
    /// Largest relative change of the amplitude; beyond it the motion is another one.
    const OTHER: f64 = 0.5;
    let deviation = |halvings: i32| {
        if halvings == 0 {
            return judged.max_deviation;
        }
        let smaller = smaller(oscillator, question.solution, &question.numbers, halvings)?;
        let response = smaller.solution.response.as_ref()?;
        let question = DrivenComparison::of_numbers(
            &smaller.oscillator,
            &smaller.solution,
            response,
            smaller.numbers,
        )
        .ok()?;
        let apart = |state: &SteadyState| (state.amplitude - judged.state.amplitude).abs();
        let states = question.states().into_iter();
        let alike = states.filter(|state| state.is_stable() == judged.state.is_stable());
        let state = alike.min_by(|one, other| apart(one).total_cmp(&apart(other)))?;
        if apart(&state) > OTHER * judged.state.amplitude {
            return None;
        }
        let found = question.truth.find_near(&question.motion, state)?;
        question.truth.compare(&question.motion, state, Some(&found)).max_deviation
    };
    let errors: Vec<f64> =
        (0..HALVINGS).map_while(deviation).take_while(|error| *error >= FLOOR).collect();
    // The halved quantity is the square of a small amplitude.
    let power = if is_small_in_amplitude(question.solution) { 2.0 } else { 1.0 };
    slopes_of(&errors).map(|slope| power * slope)
}

/// Judges the steady motions of a driven oscillator: the verdict is that on the largest stable one.
pub(super) fn judge(
    oscillator: &Oscillator,
    solution: &Solution,
    response: &Response,
    at: &Values,
    tolerance: f64,
) -> Result<Verification, VerificationError> {
    let question = DrivenComparison::new(oscillator, solution, response, at)?;
    let (states, spurious) = question.judged_states();
    let judged = states.iter().find(|judged| judged.state.is_stable()).or(states.first());
    let passed = judged.filter(|judged| judged.state.is_stable()).is_some_and(|judged| {
        let agrees = judged.true_stable == Some(judged.state.is_stable());
        // A motion without a resonant part is judged by its deviation.
        let error = judged.relative_error.or(judged.max_deviation);
        agrees && error.is_some_and(|error| error.abs() <= tolerance)
    });
    let symbols = symbol_values(oscillator, solution, &question.numbers, None);
    let moving =
        judged.filter(|judged| judged.true_amplitude.is_some() && judged.max_deviation.is_some());
    Ok(Verification {
        at: at.clone(),
        tolerance,
        frequency: Some(question.frequency),
        reason: None,
        true_frequency: question.frequency,
        relative_error: judged.and_then(|judged| judged.relative_error),
        judged_on: "amplitude",
        error_of_omega: None,
        max_deviation: judged.and_then(|judged| judged.max_deviation),
        no_deviation: None,
        residual: moving.and_then(|judged| question.residual(judged.state)),
        slope: moving.and_then(|judged| slope(oscillator, &question, judged)),
        over_several_wells: false,
        ranges: vec![],
        chosen: vec![],
        values: symbols.values,
        phase: 0.0,
        motion: None,
        steady_states: states,
        spurious,
        followed: None,
        verdict: Verdict::from_passed(passed),
    })
}

/// The verdict on a state that dry friction holds at rest.
fn held_state(state: SteadyState) -> JudgedState {
    JudgedState {
        state,
        true_amplitude: Some(0.0),
        true_stable: Some(true),
        relative_error: None,
        max_deviation: Some(0.0),
    }
}

/// The equation as it was typed, with numbers for its parameters.
struct Truth {
    force: CompiledFunction,
    period: f64,
    /// The harmonic of the period whose amplitude is meant.
    own: u32,
    /// Number of drive periods in a period of the motion.
    drives: u32,
}

impl Truth {
    fn new(
        oscillator: &Oscillator,
        numbers: &BTreeMap<Symbol, f64>,
        period: f64,
        [drives, own]: [u32; 2],
    ) -> Result<Self, VerificationError> {
        let exact = |(name, value): (&Symbol, &f64)| Some((*name, Expr::number(from_f64(*value)?)));
        let force = oscillator.force.substitute_all(&numbers.iter().filter_map(exact).collect())?;
        let arguments = [Symbol::new("t"), oscillator.coordinate, oscillator.velocity()];
        Ok(Self { force: CompiledFunction::new(&force, &arguments)?, period, own, drives })
    }

    /// Whether a mass at rest at a position stays there at all times, because friction exceeds the
    /// force in either direction.
    fn is_held(&self, place: f64) -> bool {
        const TIMES: usize = 64;
        const SPEED: f64 = 1e-12;
        let mut times = (0..TIMES).map(|k| self.period * k as f64 / TIMES as f64);
        let jumps = |t: f64| {
            let [ahead, back] = [SPEED, -SPEED].map(|speed| -self.force.call(&[t, place, speed]));
            ahead < 0.0 && back > 0.0 && ahead.abs().min(back.abs()) > 1e3 * SPEED
        };
        times.all(jumps)
    }

    /// The true periodic motion to which Newton's method leads from that of the formula, other than
    /// those with a known start.
    fn by_newton(
        &self,
        motion: &SteadyFormula,
        state: SteadyState,
        known: &[[f64; 2]],
    ) -> Option<PeriodicOrbit> {
        let start = [motion.position(0.0, state), motion.velocity(0.0, state)];
        let size = motion.size(self.period, state);
        let size = if size > 0.0 { size } else { 1.0 };
        let acceleration = |t: f64, x: f64, v: f64| -self.force.call(&[t, x, v]);
        periodic_motion(&acceleration, self.period, start, size, known)
    }

    /// The true periodic motion near that of the formula; if its stability differs, a second one of
    /// the same stability if that is near.
    fn as_stable(&self, motion: &SteadyFormula, state: SteadyState) -> Option<PeriodicOrbit> {
        /// Largest relative error of the amplitude of the second motion.
        const NEAR: f64 = 0.3;
        let found = self.find_near(motion, state)?;
        let is_alike = |found: &PeriodicOrbit| found.attracts() == state.is_stable();
        let is_near = |found: &PeriodicOrbit| {
            (state.amplitude / found.harmonic(self.own) - 1.0).abs() <= NEAR
        };
        if is_alike(&found) || state.amplitude == 0.0 {
            return Some(found);
        }
        let second = self.by_newton(motion, state, &self.initial_states(&found));
        second.filter(|second| is_alike(second) && is_near(second)).or(Some(found))
    }

    /// The true periodic motion near one by the formula.
    fn find_near(&self, motion: &SteadyFormula, state: SteadyState) -> Option<PeriodicOrbit> {
        /// Number of periods in which a motion may settle.
        const PERIODS: f64 = 200.0;
        let start = [motion.position(0.0, state), motion.velocity(0.0, state)];
        let size = motion.size(self.period, state);
        let size = if size > 0.0 { size } else { 1.0 };
        let acceleration = |t: f64, x: f64, v: f64| -self.force.call(&[t, x, v]);
        let found = periodic_motion(&acceleration, self.period, start, size, &[]);
        // Near a fold the search may fail although a simulation settles.
        let settled = || {
            let [x, v] = start;
            let options = IntegrationOptions::with_tolerance(1e-9);
            let end = PERIODS * self.period;
            let path = integrate(acceleration, State { t: 0.0, x, v }, end, &[], &options).ok()?;
            let end = path.end();
            periodic_motion(&acceleration, self.period, [end.x, end.v], size, &[])
        };
        // A motion that dry friction holds has no start to settle from.
        let settles = state.is_stable() && state.amplitude > 0.0;
        found.or_else(|| settles.then(settled).flatten())
    }

    /// A true periodic motion near one by the formula that is none of the known ones.
    fn find_another(
        &self,
        motion: &SteadyFormula,
        state: SteadyState,
        known: &[[f64; 2]],
    ) -> Option<PeriodicOrbit> {
        let start = [motion.position(0.0, state), motion.velocity(0.0, state)];
        let size = motion.size(self.period, state);
        let acceleration = |t: f64, x: f64, v: f64| -self.force.call(&[t, x, v]);
        // Further starts are half-way to each known motion: near a fold the wanted one lies
        // between.
        let half_way = |known: &[f64; 2]| [0, 1].map(|index| 0.5 * (start[index] + known[index]));
        let mut starts = std::iter::once(start).chain(known.iter().map(half_way));
        let search = || {
            starts.find_map(|start| periodic_motion(&acceleration, self.period, start, size, known))
        };
        (size > 0.0).then(search).flatten()
    }

    /// Initial states of a true motion at every period of the drive: all of them are starts of the
    /// same motion.
    fn initial_states(&self, found: &PeriodicOrbit) -> Vec<[f64; 2]> {
        let part = self.period / f64::from(self.drives);
        let start = |k: u32| found.phase_point_at(part * f64::from(k)).into();
        (0..self.drives).map(start).collect()
    }

    fn compare(
        &self,
        motion: &SteadyFormula,
        state: SteadyState,
        found: Option<&PeriodicOrbit>,
    ) -> JudgedState {
        let own = found.map(|found| found.harmonic(self.own));
        let error = own.map(|own| state.amplitude / own - 1.0);
        let deviation = found.map(|found| {
            let largest = largest_over(self.period, |t| {
                (found.phase_point_at(t).0 - motion.position(t, state)).abs()
            });
            let size = largest_over(self.period, |t| {
                (found.phase_point_at(t).0 - motion.equilibrium).abs()
            });
            if size == 0.0 { 0.0 } else { largest / size }
        });
        JudgedState {
            state,
            true_amplitude: own,
            true_stable: found.map(|found| found.attracts()),
            relative_error: error.filter(|error| state.amplitude > 0.0 && error.is_finite()),
            max_deviation: deviation.filter(|deviation| deviation.is_finite()),
        }
    }
}

/// The motion by the formula, in time, amplitude and phase.
struct SteadyFormula {
    position: CompiledFunction,
    velocity: CompiledFunction,
    acceleration: CompiledFunction,
    equilibrium: f64,
}

impl SteadyFormula {
    fn new(
        solution: &Solution,
        response: &Response,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<Self, VerificationError> {
        let value_of = |name: Symbol| numbers.get(&name).copied();
        let defined = solution.defined_values(&value_of).unwrap_or_default();
        let known = numbers.iter().map(|(name, value)| (*name, *value)).chain(defined);
        let exact = |(name, value): (Symbol, f64)| Some((name, Expr::number(from_f64(value)?)));
        let motion = response.motion.substitute_all(&known.filter_map(exact).collect())?;
        let t = Symbol::new("t");
        let phase = solution.modulation.as_ref().map_or(t, |slow| slow.phase);
        let arguments = [t, solution.amplitude.symbol(), phase];
        let velocity = motion.differentiate(t)?;
        Ok(Self {
            position: CompiledFunction::new(&motion, &arguments)?,
            velocity: CompiledFunction::new(&velocity, &arguments)?,
            acceleration: CompiledFunction::new(&velocity.differentiate(t)?, &arguments)?,
            equilibrium: solution.equilibrium.evaluate(numbers)?,
        })
    }

    fn position(&self, t: f64, state: SteadyState) -> f64 {
        self.position.call(&[t, state.amplitude, state.phase])
    }

    fn velocity(&self, t: f64, state: SteadyState) -> f64 {
        self.velocity.call(&[t, state.amplitude, state.phase])
    }

    fn acceleration(&self, t: f64, state: SteadyState) -> f64 {
        self.acceleration.call(&[t, state.amplitude, state.phase])
    }

    fn size(&self, period: f64, state: SteadyState) -> f64 {
        const SAMPLES: usize = 64;
        let place = |k: usize| {
            (self.position(period * k as f64 / SAMPLES as f64, state) - self.equilibrium).abs()
        };
        (0..SAMPLES).map(place).fold(0.0, f64::max)
    }
}

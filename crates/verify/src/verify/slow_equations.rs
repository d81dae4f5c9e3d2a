//! Slow equations of several coordinates beside the true motions.
//!
//! ```text
//! steady:     y(T) = y(0) by Newton's method from the formula,   error = max |q_formula - q_true| / max |q_true|
//! transient:  the motion from a_j, phi_j by the slow equations, and the true one from the same start
//! ```
//!
//! The true motions are followed by Taylor series of the equations as they were given, with their
//! variations where a start is sought.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

use super::{Verdict, VerificationError};
use crate::expr::{CompiledList, Expr};
use crate::interrupt::Interrupt;
use crate::multiple_scales::{EnergyExchange, SlowMotion, SlowNumbers, SlowSteadyState};
use crate::symbol::Symbol;

use crate::system::{PathEnd, Solver, System, SystemOptions, Variations};
use crate::values::Values;

/// Number of points of a period, or of a transient for each slow time.
const POINTS: usize = 256;

/// Slow equations judged at given values.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct JudgedSlowMotion {
    /// The values.
    pub at: Values,
    /// The error up to which it passes.
    pub tolerance: f64,
    /// The steady motions, the largest first.
    pub steady: Vec<JudgedSteadyMotion>,
    /// Whether there are families of steady motions as well, which are not listed.
    pub has_families: bool,
    /// The motion from the amplitudes that were given; `None` without them.
    pub transient: Option<JudgedTransient>,
    /// Whether the stable steady motions, or the transient, are within the tolerance; `None` where
    /// none was compared.
    pub verdict: Option<Verdict>,
}

/// A steady motion beside the true one.
#[derive(Clone, Debug)]
pub struct JudgedSteadyMotion {
    /// The steady motion of the slow equations.
    pub state: SlowSteadyState,
    /// Whether the motion is periodic with the drive, so that the true one was sought.
    pub compared: bool,
    /// The largest deviation of a coordinate over a period, as a part of the largest displacement;
    /// `None` if no true motion was found near.
    pub error: Option<f64>,
    /// Whether the true motion is stable, by its multipliers.
    pub truly_stable: Option<bool>,
}

/// A motion whose amplitudes change, beside the true one.
#[derive(Clone, Debug)]
pub struct JudgedTransient {
    /// The time over which both are compared.
    pub until: f64,
    /// The largest deviation of a coordinate, as a part of the largest displacement.
    pub error: f64,
    /// The exchange of energy between the modes by the slow equations; `None` where there is none in
    /// closed form.
    pub exchange: Option<EnergyExchange>,
    /// The times, and the coordinates by the formula and in truth at each.
    pub times: Vec<f64>,
    /// By the formula, a row for each time.
    pub formula: Vec<Vec<f64>>,
    /// In truth.
    pub truth: Vec<Vec<f64>>,
}

/// Judges slow equations at values of all parameters: steady motions by shooting, and, where values of
/// the amplitudes are given, the motion from them by integration.
///
/// # Errors
/// [`VerificationError`] for missing or unknown values.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::multiple_scales::{CoupledSystem, MultipleScalesOptions, derive};
/// use lindstedt::verify::judge_slow_motion;
///
/// let system = CoupledSystem::parse(
///     "u'' + u'/50 + u - 2*u*v/5 = 0; v'' + v'/50 + 4*v - 3*u^2/10 = F*cos(Omega*t)",
/// )?;
/// let resonance = Some("omega2 = 2*omega1, Omega = omega2".to_owned());
/// let slow = derive(&system, &MultipleScalesOptions { resonance, ..Default::default() })?;
/// let judged = judge_slow_motion(&slow, &"F = 1/125, Omega = 2".parse()?, 0.02)?;
/// let stable: Vec<_> = judged.steady.iter().filter(|motion| motion.state.is_stable()).collect();
/// assert!((stable[0].state.amplitudes[1] - 0.1).abs() < 1e-12, "saturation");
/// assert!(stable[0].error.is_some_and(|error| error < 0.02));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn judge_slow_motion(
    slow: &SlowMotion,
    at: &Values,
    tolerance: f64,
) -> Result<JudgedSlowMotion, VerificationError> {
    let truth = TrueMotion::new(slow, at)?;
    let started = slow.amplitudes.iter().any(|name| truth.numbers.contains_key(name));
    let transient = if started { Some(truth.transient()?) } else { None };
    let mut has_families = false;
    let steady = match started {
        true => vec![],
        false => {
            let states = truth.slow_numbers.steady_states(Interrupt::default());
            has_families = states.has_families;
            states.isolated.into_iter().map(|state| truth.judged(state)).collect()
        }
    };
    let compared = steady.iter().filter(|motion| motion.compared && motion.state.is_stable());
    let errors: Vec<Option<f64>> = match &transient {
        Some(transient) => vec![Some(transient.error)],
        None => compared.map(|motion| motion.error).collect(),
    };
    let within = |error: &Option<f64>| error.is_some_and(|error| error <= tolerance);
    let verdict = (!errors.is_empty()).then(|| Verdict::from_passed(errors.iter().all(within)));
    Ok(JudgedSlowMotion { at: at.clone(), tolerance, steady, has_families, transient, verdict })
}

/// The equations with numbers, and the formulas of the motion.
struct TrueMotion<'a> {
    slow: &'a SlowMotion,
    numbers: BTreeMap<Symbol, f64>,
    slow_numbers: SlowNumbers,
    /// The equations alone, and with their variations.
    solver: Solver,
    varied: Solver,
    /// The coordinates, then their velocities, at the time, amplitudes and phases, with the rates of
    /// these.
    motion: CompiledList,
    base: Option<f64>,
}

impl<'a> TrueMotion<'a> {
    fn new(slow: &'a SlowMotion, at: &Values) -> Result<Self, VerificationError> {
        let equations = &slow.system.equations;
        let mut known = equations.parameters.clone();
        known.extend(slow.amplitudes.iter().chain(&slow.phases));
        let numbers = at.numbers();
        if let Some(name) = numbers.keys().find(|name| !known.contains(name)) {
            return Err(VerificationError::Unknown { name: *name, known });
        }
        let missing = |name| VerificationError::Missing(vec![name]);
        let absent: Vec<Symbol> = equations
            .parameters
            .iter()
            .copied()
            .filter(|name| !numbers.contains_key(name))
            .collect();
        if !absent.is_empty() {
            return Err(VerificationError::Missing(absent));
        }
        let value_of = |name: Symbol| numbers.get(&name).copied();
        let slow_numbers = slow.in_numbers(&value_of).map_err(missing)?;
        let named: BTreeMap<Symbol, f64> = slow
            .values(&value_of)
            .map_err(missing)?
            .into_iter()
            .chain(numbers.iter().map(|(name, value)| (*name, *value)))
            .filter(|(name, _)| !slow.amplitudes.contains(name) && !slow.phases.contains(name))
            .chain([(Symbol::new("pi"), std::f64::consts::PI)])
            .collect();
        let t = Symbol::new("t");
        let failed = |error: &dyn std::fmt::Display| VerificationError::NoSystem(error.to_string());
        let rates = &equations.rates;
        let options = SystemOptions { step_limit: 200_000, ..SystemOptions::default() };
        let solver = System::new(&rates.states, t, &rates.right, &named)
            .map_err(|error| failed(&error))?
            .solver(&[], &options);
        let taken: Vec<Symbol> = named.keys().copied().chain([t]).collect();
        let variations = Variations::new(&rates.states, &rates.right, None, &taken)
            .map_err(|error| failed(&error))?;
        let varied = System::new(&variations.states, t, &variations.right, &named)
            .map_err(|error| failed(&error))?
            .solver(&[], &options);
        let motion = motion_and_velocity(slow, &named).map_err(|error| failed(&error))?;
        let base = slow.base.as_ref().map(|base| base.evaluate(&named)).transpose();
        let base = base.map_err(|error| failed(&error))?;
        Ok(Self { slow, numbers, slow_numbers, solver, varied, motion, base })
    }

    /// Coordinates, then velocities, at a time.
    fn at(&self, time: f64, amplitudes: &[Complex<f64>]) -> Vec<f64> {
        let rates = self.slow_numbers.rates(amplitudes);
        let polar = amplitudes.iter().map(|b| [2.0 * b.norm(), b.arg()]);
        // B' = (a' + i a phi') e^(i phi)/2
        let turned = amplitudes.iter().zip(&rates).map(|(b, rate)| match b.norm() > 0.0 {
            true => {
                let turned = rate * b.conj() / b.norm();
                [2.0 * turned.re, turned.im / b.norm()]
            }
            false => [2.0 * rate.norm(), 0.0],
        });
        let arguments: Vec<f64> =
            std::iter::once(time).chain(polar.flatten()).chain(turned.flatten()).collect();
        let mut values = vec![f64::NAN; 2 * self.slow.motion.len()];
        self.motion.call(&arguments, &mut vec![], &mut values);
        values
    }

    /// A steady motion beside the true one, which is sought from its start.
    fn judged(&self, state: SlowSteadyState) -> JudgedSteadyMotion {
        let Some(base) = self.base.filter(|_| self.slow.is_periodic(&state)) else {
            return JudgedSteadyMotion { state, compared: false, error: None, truly_stable: None };
        };
        let period = TAU / base.abs();
        let amplitudes: Vec<Complex<f64>> = state
            .amplitudes
            .iter()
            .zip(&state.phases)
            .map(|(a, phase)| Complex::from_polar(a / 2.0, *phase))
            .collect();
        let found = self.closed(period, &self.at(0.0, &amplitudes));
        let error = found.as_ref().and_then(|(start, _)| {
            let times: Vec<f64> =
                (0..=POINTS).map(|index| period * index as f64 / POINTS as f64).collect();
            let truth = self.followed(start, &times)?;
            let formula = times.iter().map(|time| self.at(*time, &amplitudes)).collect::<Vec<_>>();
            deviation(&formula, &truth)
        });
        let truly_stable = found.map(|(_, largest)| largest < 1.0);
        JudgedSteadyMotion { state, compared: true, error, truly_stable }
    }

    /// The start of the motion that closes after a period, near this one, and the size of its largest
    /// multiplier.
    fn closed(&self, period: f64, near: &[f64]) -> Option<(Vec<f64>, f64)> {
        const ITERATIONS: usize = 12;
        let count = near.len();
        let mut start = DVector::from_column_slice(near);
        let size = start.norm();
        for _ in 0..ITERATIONS {
            let varied = Variations::start(start.as_slice(), false);
            let path = self.varied.solve([0.0, period], &varied).ok()?;
            let end = path.states_at(period).filter(|_| path.reason() == PathEnd::Reached)?;
            let map = DMatrix::from_fn(count, count, |row, column| end[count * (column + 1) + row]);
            let rest = DVector::from_fn(count, |row, _| end[row] - start[row]);
            let step = (&map - DMatrix::identity(count, count)).lu().solve(&rest)?;
            if !step.iter().all(|entry| entry.is_finite()) || step.norm() > size {
                return None;
            }
            start -= &step;
            if step.norm() <= 1e-11 * size {
                let multipliers = map.complex_eigenvalues();
                let largest = multipliers.iter().map(|value| value.norm()).fold(0.0, f64::max);
                return Some((start.as_slice().to_vec(), largest));
            }
        }
        None
    }

    /// The coordinates of the true motion at these times.
    fn followed(&self, start: &[f64], times: &[f64]) -> Option<Vec<Vec<f64>>> {
        let path = self.solver.solve([0.0, *times.last()?], start).ok()?;
        if path.reason() != PathEnd::Reached {
            return None;
        }
        let mut columns = vec![Vec::new(); start.len()];
        path.sample(times, &mut Vec::new(), &mut columns);
        let count = self.slow.motion.len();
        (0..times.len())
            .map(|index| {
                columns.iter().take(count).map(|column| column.get(index).copied()).collect()
            })
            .collect()
    }

    /// The motion from the amplitudes and phases that were given, over some slow times.
    fn transient(&self) -> Result<JudgedTransient, VerificationError> {
        /// The turns of the slow motion, and the greatest number of waves and of points.
        const TURNS: f64 = 2.0;
        const WAVES: f64 = 400.0;
        const STEPS: usize = 40;
        let value = |name: &Symbol| self.numbers.get(name).copied();
        let missing: Vec<Symbol> =
            self.slow.amplitudes.iter().copied().filter(|name| value(name).is_none()).collect();
        if !missing.is_empty() {
            return Err(VerificationError::Missing(missing));
        }
        let mut amplitudes: Vec<Complex<f64>> = self
            .slow
            .amplitudes
            .iter()
            .zip(&self.slow.phases)
            .map(|(a, phase)| {
                Complex::from_polar(value(a).unwrap_or(0.0) / 2.0, value(phase).unwrap_or(0.0))
            })
            .collect();
        let size = amplitudes.iter().map(|b| b.norm()).fold(0.0, f64::max);
        if size == 0.0 && self.slow.system.drives.is_empty() {
            return Err(VerificationError::AtRest);
        }
        let named = |name: Symbol| self.numbers.get(&name).copied();
        let values: BTreeMap<Symbol, f64> = self
            .slow
            .values(&named)
            .map_err(|name| VerificationError::Missing(vec![name]))?
            .into_iter()
            .chain(self.numbers.clone())
            .collect();
        let frequencies: Vec<f64> = self
            .slow
            .references
            .iter()
            .map(|nu| nu.evaluate(&values).unwrap_or(f64::NAN).abs())
            .collect();
        let slowest = frequencies.iter().copied().fold(f64::INFINITY, f64::min);
        let fastest = frequencies.iter().copied().fold(0.0, f64::max);
        let rate = self.slow_numbers.rates(&amplitudes).iter().map(|rate| rate.norm()).sum::<f64>();
        let longest = WAVES * TAU / slowest;
        let until = if rate > 0.0 && size > 0.0 {
            (TURNS * TAU * size / rate).min(longest)
        } else {
            longest
        };
        let exchange = self.exchange(&values);
        // A whole exchange is compared where it is not too long.
        let until = exchange.as_ref().map_or(until, |own| until.max(own.period.min(longest)));
        let start = self.at(0.0, &amplitudes);
        // Some thirty points a wave of the fastest mode, each reached by steps of the slow equations.
        let points = (32.0 * until * fastest / TAU).ceil().clamp(64.0, 40_000.0) as usize;
        let times: Vec<f64> =
            (0..=points).map(|index| until * index as f64 / points as f64).collect();
        let step = until / points as f64;
        let mut formula = vec![start.clone()];
        let substeps = STEPS.min(1 + (step * rate / size.max(f64::MIN_POSITIVE) * 100.0) as usize);
        for time in times.iter().skip(1) {
            for _ in 0..substeps {
                amplitudes = self.stepped(&amplitudes, step / substeps as f64);
            }
            formula.push(self.at(*time, &amplitudes));
        }
        let truth = self.followed(&start, &times).ok_or_else(|| {
            VerificationError::NoSystem(
                "the true motion from there grows without bound, or cannot be followed so long"
                    .to_owned(),
            )
        })?;
        let count = self.slow.motion.len();
        formula.iter_mut().for_each(|place| place.truncate(count));
        let error = deviation(&formula, &truth).unwrap_or(f64::INFINITY);
        Ok(JudgedTransient { until, error, exchange, times, formula, truth })
    }

    /// The exchange of energy from the amplitudes and phases that were given.
    fn exchange(&self, values: &BTreeMap<Symbol, f64>) -> Option<EnergyExchange> {
        let value = |name: &Symbol| values.get(name).copied();
        let amplitudes: Vec<(Symbol, f64)> = self
            .slow
            .amplitudes
            .iter()
            .map(|name| Some((*name, value(name)?)))
            .collect::<Option<_>>()?;
        let (_, turns) = self.slow.slow_phases.first()?;
        let phases = turns.iter().zip(&self.slow.phases);
        let phase = phases.map(|(turn, name)| f64::from(*turn) * value(name).unwrap_or(0.0)).sum();
        self.slow.invariants()?.exchange(&amplitudes, phase, &|name| value(&name))
    }

    /// A step of the slow equations by the classical method of Runge and Kutta.
    fn stepped(&self, from: &[Complex<f64>], step: f64) -> Vec<Complex<f64>> {
        let moved = |rates: &[Complex<f64>], part: f64| -> Vec<Complex<f64>> {
            from.iter().zip(rates).map(|(b, rate)| b + rate * (part * step)).collect()
        };
        let first = self.slow_numbers.rates(from);
        let second = self.slow_numbers.rates(&moved(&first, 0.5));
        let third = self.slow_numbers.rates(&moved(&second, 0.5));
        let fourth = self.slow_numbers.rates(&moved(&third, 1.0));
        let mean =
            |mode: usize| (first[mode] + (second[mode] + third[mode]) * 2.0 + fourth[mode]) / 6.0;
        from.iter().enumerate().map(|(mode, b)| b + mean(mode) * step).collect()
    }
}

/// The largest deviation over the largest displacement; `None` where the truth stands still.
fn deviation(formula: &[Vec<f64>], truth: &[Vec<f64>]) -> Option<f64> {
    let (mut largest, mut apart) = (0.0_f64, 0.0_f64);
    for (formula, truth) in formula.iter().zip(truth) {
        for (formula, truth) in formula.iter().zip(truth) {
            largest = largest.max(truth.abs());
            apart = apart.max((formula - truth).abs());
        }
    }
    (largest > 0.0).then(|| apart / largest).filter(|error| error.is_finite())
}

/// The coordinates and their velocities as functions of the time, of each amplitude and phase, and of
/// the rates of these.
fn motion_and_velocity(
    slow: &SlowMotion,
    named: &BTreeMap<Symbol, f64>,
) -> Result<CompiledList, Box<dyn std::error::Error>> {
    let t = Symbol::new("t");
    let own = || slow.amplitudes.iter().zip(&slow.phases).flat_map(|(a, phase)| [*a, *phase]);
    let rates: Vec<Symbol> = own().map(Symbol::derivative).collect();
    let mut velocities = Vec::new();
    for motion in &slow.motion {
        let mut sum = motion.differentiate(t)?;
        for (name, rate) in own().zip(&rates) {
            sum = sum + motion.differentiate(name)? * Expr::from(*rate);
        }
        velocities.push(sum);
    }
    let all: Vec<Expr> = slow
        .motion
        .iter()
        .chain(&velocities)
        .map(|expression| {
            let known: BTreeMap<Symbol, Expr> = named
                .iter()
                .filter(|(name, _)| expression.contains(**name))
                .filter_map(|(name, value)| {
                    Some((*name, Expr::number(crate::exact::rational::from_f64(*value)?)))
                })
                .collect();
            expression.substitute_all(&known)
        })
        .collect::<Result<_, _>>()?;
    let arguments: Vec<Symbol> = std::iter::once(t).chain(own()).chain(rates).collect();
    Ok(CompiledList::new(&all, &arguments)?)
}

//! Slow equations of several coordinates beside the true motions.
//!
//! ```text
//! steady:     y(T) = y(0) by Newton's method from the formula,   error = max |q_formula - q_true| / max |q_true|
//! undriven:   T is an unknown as well, and y(0) lies in the plane at right angles to the motion of the formula
//! transient:  the motion from a_j, phi_j by the slow equations, and the true one from the same start
//! ```
//!
//! The true motions are followed by Taylor series of the equations as they were given, with their
//! variations where a start is sought.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::linalg::Schur;
use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

use super::slope::slopes_of;
use super::{Verdict, VerificationError};
use crate::exact::rational::{from_f64, ratio};
use crate::expr::{CompiledList, Expr, ExprError};
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
    /// Measured exponent of the deviation of the transient, or of the largest stable steady motion, by
    /// halving of everything that is small; `None` if rounding hides it or nothing was compared.
    pub slope: Option<f64>,
    /// Whether the stable steady motions, or the transient, are within the tolerance; `None` where
    /// none was compared.
    pub verdict: Option<Verdict>,
}

/// A steady motion beside the true one.
#[derive(Clone, Debug)]
pub struct JudgedSteadyMotion {
    /// The steady motion of the slow equations.
    pub state: SlowSteadyState,
    /// Whether the motion is periodic, so that the true one was sought.
    pub compared: bool,
    /// The largest deviation of a coordinate over a period, at the same part of it, over the largest
    /// displacement; `None` if no true motion was found near.
    pub error: Option<f64>,
    /// The frequency of a motion that nothing drives, and the true one where it was found.
    pub frequency: Option<(f64, Option<f64>)>,
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
/// the amplitudes are given, the motion from them by integration. Once the interrupt is requested, no
/// further steady motions are sought, nor the slope.
///
/// # Errors
/// [`VerificationError`] for missing or unknown values.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::Interrupt;
/// use lindstedt::multiple_scales::{CoupledSystem, MultipleScalesOptions, derive};
/// use lindstedt::verify::judge_slow_motion;
///
/// let system = CoupledSystem::parse(
///     "u'' + u'/50 + u - 2*u*v/5 = 0; v'' + v'/50 + 4*v - 3*u^2/10 = F*cos(Omega*t)",
/// )?;
/// let resonance = Some("omega2 = 2*omega1, Omega = omega2".to_owned());
/// let slow = derive(&system, &MultipleScalesOptions { resonance, ..Default::default() })?;
/// let at = "F = 1/125, Omega = 2".parse()?;
/// let judged = judge_slow_motion(&slow, &at, 0.02, Interrupt::default())?;
/// let stable: Vec<_> = judged.steady.iter().filter(|motion| motion.state.is_stable()).collect();
/// assert!((stable[0].state.amplitudes[1] - 0.1).abs() < 1e-12, "saturation");
/// assert!(stable[0].error.is_some_and(|error| error < 0.02));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn judge_slow_motion(
    slow: &SlowMotion,
    at: &Values,
    tolerance: f64,
    interrupt: Interrupt,
) -> Result<JudgedSlowMotion, VerificationError> {
    let truth = TrueMotion::new(slow, at, interrupt)?;
    let mut polar = slow.amplitudes.iter().chain(&slow.phases);
    let started = polar.any(|name| truth.numbers.contains_key(name));
    let transient = if started { Some(truth.transient(None)?) } else { None };
    let mut has_families = false;
    let steady = match started {
        true => vec![],
        false => {
            let states = truth.slow_numbers.steady_states(interrupt);
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
    let slope = match &transient {
        Some(transient) => slope(slow, transient.error, |smaller, halvings| {
            let longer = 2.0_f64.powi(halvings * i32::try_from(slow.small_order).unwrap_or(1));
            let truth = TrueMotion::new(smaller, at, interrupt).ok()?;
            Some(truth.transient(Some(transient.until * longer)).ok()?.error)
        }),
        None => {
            let stable = |motion: &&JudgedSteadyMotion| motion.state.is_stable();
            steady.iter().find(stable).and_then(|motion| {
                slope(slow, motion.error?, |smaller, _| {
                    let truth = TrueMotion::new(smaller, at, interrupt).ok()?;
                    truth.judged(truth.nearest(&motion.state)?).error
                })
            })
        }
    };
    let at = at.clone();
    Ok(JudgedSlowMotion { at, tolerance, steady, has_families, transient, slope, verdict })
}

/// The exponent of an error, by halving of everything that is small: `error` is that of smaller terms
/// with the number of halvings, `whole` that of the terms as they are.
fn slope(
    slow: &SlowMotion,
    whole: f64,
    error: impl Fn(&SlowMotion, i32) -> Option<f64>,
) -> Option<f64> {
    const HALVINGS: i32 = 2;
    /// True motions are accurate to some 1e-11.
    const FLOOR: f64 = 1e-9;
    let smaller = (1..=HALVINGS).map_while(|halvings| {
        let part = ratio(1, 1 << halvings);
        error(&slow.with_small_terms_times(&part).ok()?, halvings)
    });
    let errors: Vec<f64> =
        std::iter::once(whole).chain(smaller).take_while(|error| *error >= FLOOR).collect();
    slopes_of(&errors)
}

/// The equations with numbers, and the formulas of the motion.
struct TrueMotion<'a> {
    slow: &'a SlowMotion,
    numbers: BTreeMap<Symbol, f64>,
    /// The values of the parameters and of what the formulas name.
    named: BTreeMap<Symbol, f64>,
    slow_numbers: SlowNumbers,
    interrupt: Interrupt,
    /// The equations alone, and with their variations.
    solver: Solver,
    varied: Solver,
    /// The coordinates, then their velocities, at the time, amplitudes and phases, with the rates of
    /// these.
    motion: CompiledList,
    /// The rates of coordinates and velocities where no time stands in them.
    rates: CompiledList,
    /// The reference frequency of each mode.
    references: Vec<f64>,
}

impl<'a> TrueMotion<'a> {
    fn new(
        slow: &'a SlowMotion,
        at: &Values,
        interrupt: Interrupt,
    ) -> Result<Self, VerificationError> {
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
        let options = SystemOptions { step_limit: 200_000, interrupt, ..SystemOptions::default() };
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
        let references = slow.references.iter().map(|nu| nu.evaluate(&named).unwrap_or(f64::NAN));
        let references = references.collect();
        let right: Vec<Expr> = rates
            .right
            .iter()
            .map(|rate| in_numbers(rate, named.iter().chain([(&t, &0.0)])))
            .collect::<Result<_, _>>()
            .map_err(|error| failed(&error))?;
        let rates = CompiledList::new(&right, &rates.states).map_err(|error| failed(&error))?;
        Ok(Self {
            slow,
            numbers,
            slow_numbers,
            solver,
            varied,
            motion,
            rates,
            references,
            named,
            interrupt,
        })
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
        let driven = self.slow.driven_frequency(&state);
        let driven =
            driven.and_then(|frequency| frequency.evaluate(&self.named).ok()).map(f64::abs);
        let own = if driven.is_none() { self.own_frequency(&state) } else { None };
        let Some(frequency) = driven.or(own) else {
            return JudgedSteadyMotion {
                state,
                compared: false,
                error: None,
                frequency: None,
                truly_stable: None,
            };
        };
        let place = |time: f64| {
            let modes = state.amplitudes.iter().zip(&state.phases).zip(&state.turning);
            let amplitudes: Vec<Complex<f64>> = modes
                .map(|((a, phase), rate)| Complex::from_polar(a / 2.0, phase + rate * time))
                .collect();
            self.at(time, &amplitudes)
        };
        let found = self.closed(TAU / frequency, &place(0.0), own.is_some());
        let parts = |period: f64| -> Vec<f64> {
            (0..=POINTS).map(|index| period * index as f64 / POINTS as f64).collect()
        };
        let error = found.as_ref().and_then(|found| {
            let truth = self.followed(&found.start, &parts(found.period))?;
            let formula = parts(TAU / frequency).into_iter().map(place).collect::<Vec<_>>();
            deviation(&formula, &truth)
        });
        let truth = found.as_ref().map(|found| TAU / found.period);
        JudgedSteadyMotion {
            state,
            compared: true,
            error,
            frequency: own.map(|own| (own, truth)),
            truly_stable: found.map(|found| found.largest < 1.0),
        }
    }

    /// The steady motion whose amplitudes are nearest to those of another, of the same stability.
    fn nearest(&self, other: &SlowSteadyState) -> Option<SlowSteadyState> {
        /// The largest distance in the amplitudes; beyond it the motion is another one.
        const OTHER: f64 = 0.2;
        const STARTS: usize = 100;
        let known = std::slice::from_ref(other);
        let found = self.slow_numbers.steady_states_near(known, STARTS, self.interrupt);
        let apart = |state: &SlowSteadyState| {
            let pairs = state.amplitudes.iter().zip(&other.amplitudes);
            pairs.map(|(one, other)| (one - other).powi(2)).sum::<f64>().sqrt()
        };
        let size = other.amplitudes.iter().map(|a| a * a).sum::<f64>().sqrt();
        let alike = found
            .isolated
            .into_iter()
            .filter(|state| state.is_stable() == other.is_stable() && apart(state) <= OTHER * size);
        alike.min_by(|one, other| apart(one).total_cmp(&apart(other)))
    }

    /// The frequency of a steady motion that nothing drives, of which those of all its modes are
    /// multiples; `None` of rest, and where the slow phases leave the modes free of each other.
    fn own_frequency(&self, state: &SlowSteadyState) -> Option<f64> {
        /// The largest number of periods of the slowest mode in one of the motion, and the largest
        /// distance of a ratio from a whole number.
        const PERIODS: i32 = 12;
        const WHOLE: f64 = 1e-6;
        if !self.slow.system.drives.is_empty() || !self.slow.is_locked_together(state) {
            return None;
        }
        let modes = self.references.iter().zip(&state.turning).zip(&state.amplitudes);
        let moving: Vec<f64> =
            modes.filter(|(_, a)| **a > 0.0).map(|((nu, rate), _)| (nu + rate).abs()).collect();
        let slowest = moving.iter().copied().reduce(f64::min).filter(|slowest| *slowest > 0.0)?;
        let divides = |part: &f64| {
            moving.iter().all(|mode| {
                let ratio = mode / part;
                (ratio - ratio.round()).abs() < WHOLE
            })
        };
        (1..=PERIODS).map(|periods| slowest / f64::from(periods)).find(divides)
    }

    /// The motion that closes after a period, near one with this start. Where nothing drives it the
    /// period is an unknown, and the start stays in the plane at right angles to the motion there.
    fn closed(&self, period: f64, near: &[f64], undriven: bool) -> Option<ClosedMotion> {
        const ITERATIONS: usize = 12;
        let count = near.len();
        let near = DVector::from_column_slice(near);
        let along = self.rates_at(near.as_slice());
        let (mut start, mut period) = (near.clone(), period);
        let size = start.norm();
        for _ in 0..ITERATIONS {
            let varied = Variations::start(start.as_slice(), false);
            let path = self.varied.solve([0.0, period], &varied).ok()?;
            let end = path.states_at(period).filter(|_| path.reason() == PathEnd::Reached)?;
            let map = DMatrix::from_fn(count, count, |row, column| end[count * (column + 1) + row]);
            let mut rest = DVector::from_fn(count, |row, _| end[row] - start[row]);
            let mut slopes = &map - DMatrix::identity(count, count);
            if undriven {
                let leaving = self.rates_at(&end[..count]);
                slopes = slopes.insert_column(count, 0.0).insert_row(count, 0.0);
                slopes.view_mut((0, count), (count, 1)).copy_from(&leaving);
                slopes.view_mut((count, 0), (1, count)).tr_copy_from(&along);
                rest = rest.insert_row(count, along.dot(&(&start - &near)));
            }
            let step = slopes.lu().solve(&rest)?;
            let moved = step.rows(0, count);
            if !step.iter().all(|entry| entry.is_finite()) || moved.norm() > size {
                return None;
            }
            start -= moved;
            let later = if undriven { step[count] } else { 0.0 };
            // A period of another motion.
            if later.abs() > 0.3 * period {
                return None;
            }
            period -= later;
            if moved.norm() <= 1e-11 * size && later.abs() <= 1e-11 * period {
                let mut multipliers: Vec<f64> =
                    multipliers(&map)?.iter().map(|value| value.norm()).collect();
                if undriven {
                    // The motion itself, later: a multiplier that is one.
                    let apart = |size: &f64| (size - 1.0).abs();
                    multipliers.sort_by(|one, other| apart(one).total_cmp(&apart(other)));
                    multipliers.remove(0);
                }
                let largest = multipliers.into_iter().fold(0.0, f64::max);
                return Some(ClosedMotion { start: start.as_slice().to_vec(), period, largest });
            }
        }
        None
    }

    /// The rates of coordinates and velocities.
    fn rates_at(&self, states: &[f64]) -> DVector<f64> {
        let mut rates = DVector::from_element(states.len(), f64::NAN);
        self.rates.call(states, &mut vec![], rates.as_mut_slice());
        rates
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

    /// The motion from the amplitudes and phases that were given, until a time, or over some slow times.
    fn transient(&self, until: Option<f64>) -> Result<JudgedTransient, VerificationError> {
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
        let frequencies: Vec<f64> = self.references.iter().map(|nu| nu.abs()).collect();
        let slowest = frequencies.iter().copied().fold(f64::INFINITY, f64::min);
        let fastest = frequencies.iter().copied().fold(0.0, f64::max);
        let rate = self.slow_numbers.rates(&amplitudes).iter().map(|rate| rate.norm()).sum::<f64>();
        let longest = WAVES * TAU / slowest;
        let some_turns = match rate > 0.0 && size > 0.0 {
            true => (TURNS * TAU * size / rate).min(longest),
            false => longest,
        };
        let exchange = self.exchange(&values);
        // A whole exchange is compared where it is not too long.
        let whole = exchange.as_ref().map_or(0.0, |own| own.period.min(longest));
        let until = until.unwrap_or(some_turns.max(whole));
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

/// A true motion that comes back.
struct ClosedMotion {
    /// Coordinates and velocities at `t = 0`.
    start: Vec<f64>,
    period: f64,
    /// The size of the largest multiplier, that of the motion itself left out.
    largest: f64,
}

/// The eigenvalues of a matrix, without more steps than such a matrix takes.
fn multipliers(map: &DMatrix<f64>) -> Option<DVector<Complex<f64>>> {
    Some(Schur::try_new(map.clone(), f64::EPSILON, 10_000)?.complex_eigenvalues())
}

/// The largest deviation over the largest displacement; `None` where the truth alone stands still.
fn deviation(formula: &[Vec<f64>], truth: &[Vec<f64>]) -> Option<f64> {
    let (mut largest, mut apart) = (0.0_f64, 0.0_f64);
    for (formula, truth) in formula.iter().zip(truth) {
        for (formula, truth) in formula.iter().zip(truth) {
            largest = largest.max(truth.abs());
            apart = apart.max((formula - truth).abs());
        }
    }
    match (largest > 0.0, apart > 0.0) {
        (false, false) => Some(0.0),
        _ => Some(apart / largest).filter(|error| error.is_finite()),
    }
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
        .map(|expression| in_numbers(expression, named))
        .collect::<Result<_, _>>()?;
    let arguments: Vec<Symbol> = std::iter::once(t).chain(own()).chain(rates).collect();
    Ok(CompiledList::new(&all, &arguments)?)
}

/// An expression with the numbers of these names.
fn in_numbers<'a>(
    expression: &Expr,
    named: impl IntoIterator<Item = (&'a Symbol, &'a f64)>,
) -> Result<Expr, ExprError> {
    let known: BTreeMap<Symbol, Expr> = named
        .into_iter()
        .filter(|(name, _)| expression.contains(**name))
        .filter_map(|(name, value)| Some((*name, Expr::number(from_f64(*value)?))))
        .collect();
    expression.substitute_all(&known)
}

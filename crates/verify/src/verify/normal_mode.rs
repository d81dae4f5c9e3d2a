//! Nonlinear normal modes beside the true motions, by shooting over half a period.
//!
//! ```text
//! q'(0) = 0,  q'(h) = 0:   both ends are turns, so that the motion comes back after T = 2 h = 2 pi/omega
//! amplitude: of the first harmonic of  s = u^T M q/(u^T M v),   a = (2/h) int_0^h s cos(pi t/h) dt
//! ```
//!
//! The motions are followed by Taylor series of the equations as they were given, and in amplitude
//! from the linear mode on, by Newton's method for q(0) and h; formulas are not used. The sum of the
//! integral is as exact as the motion, for s is even about both ends.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector};

use super::{Verdict, VerificationError};
use crate::coupled::Energy;
use crate::exact::{Doubles, Polynomial};
use crate::interrupt::Interrupt;
use crate::modes::{BalanceStart, FreeSystem, ModeInNumbers, NearResonance, NonlinearMode};
use crate::numeric::continuation::in_amplitude;
use crate::parallel::par_map;
use crate::series::FourierSeries;
use crate::solution::{AmplitudeConvention, Definition, defined_values};
use crate::symbol::Symbol;
use crate::system::{PathEnd, Solver, System, SystemOptions};
use crate::values::Values;

/// Number of points of half a period, beside the end.
const POINTS: usize = 128;

/// A nonlinear normal mode judged at given values.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct JudgedMode {
    /// The values.
    pub at: Values,
    /// The relative error up to which it passes.
    pub tolerance: f64,
    /// omega by the formula; `None` if its square is not positive.
    pub frequency: Option<f64>,
    /// The coefficients of `omega^2` in powers of the amplitude with numbers for all letters, the constant
    /// first; none where the formula is no polynomial of it.
    pub law: Vec<f64>,
    /// The coefficients that a balance of harmonics has at the values; none of a series.
    pub coefficients: Vec<(Symbol, f64)>,
    /// omega of the true motion.
    pub true_frequency: f64,
    /// `frequency / true_frequency - 1`.
    pub relative_error: Option<f64>,
    /// Largest deviation of a coordinate over a period, at the same theta, as a part of the largest
    /// displacement.
    pub max_deviation: f64,
    /// The other modes whose frequency at these values is near a multiple that occurs in the motion.
    pub near: Vec<NearResonance>,
    /// Measured exponent of the error of the frequency, from two amplitudes of which one is half of
    /// the other, as small as rounding allows; `None` if it hides the error.
    pub slope: Option<f64>,
    /// The mode from small amplitudes up to this one.
    pub backbone: Vec<BackbonePoint>,
    /// Half a period by the formula and in truth, at equal steps of theta from 0 to pi: the
    /// coordinates at each.
    pub paths: [Vec<Vec<f64>>; 2],
    /// The verdict on the frequency.
    pub verdict: Verdict,
}

/// A motion of a mode at an amplitude up to that at which it is judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BackbonePoint {
    /// The amplitude.
    pub amplitude: f64,
    /// omega by the formula; `None` if its square is not positive.
    pub frequency: Option<f64>,
    /// omega of the true motion.
    pub true_frequency: f64,
    /// The energy of the true motion over that of rest; `None` where the forces have no potential that is
    /// known.
    pub energy: Option<f64>,
}

/// A true motion of a mode.
#[derive(Clone)]
struct Motion {
    /// q(0), then h.
    unknowns: DVector<f64>,
    /// The coordinates at equal steps of half a period.
    path: Vec<Vec<f64>>,
}

impl Motion {
    fn frequency(&self) -> f64 {
        PI / self.unknowns[self.unknowns.len() - 1]
    }
}

/// Judges a mode at values of the amplitude and of all parameters. Its true motions are followed until
/// the interrupt is requested.
///
/// # Errors
/// [`VerificationError`] for missing or unknown values, where no true motion was found, and where the
/// search was interrupted.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::Interrupt;
/// use lindstedt::modes::{FreeSystem, ModeOptions, derive};
/// use lindstedt::verify::judge_mode;
///
/// let pair = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0")?;
/// let modes = derive(&pair, &ModeOptions::default())?;
/// let mode = modes.modes[0].as_ref().expect("no resonance");
/// let judged = judge_mode(&modes.system, mode, &"a = 1/2".parse()?, 0.01, Interrupt::default())?;
/// assert!(judged.relative_error.is_some_and(|error| error.abs() < 1e-4));
/// assert!(judged.slope.is_some_and(|slope| (slope - 6.0).abs() < 0.1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn judge_mode(
    system: &FreeSystem,
    mode: &NonlinearMode,
    at: &Values,
    tolerance: f64,
    interrupt: Interrupt,
) -> Result<JudgedMode, VerificationError> {
    let amplitude = mode.amplitude.symbol();
    let numbers = checked(system, amplitude, at)?;
    let size = numbers[&amplitude];
    if size == 0.0 {
        return Err(VerificationError::AtRest);
    }
    if let Some(divisor) = vanishing_divisor(mode, &numbers) {
        return Err(VerificationError::VanishingDivisor { number: mode.number, divisor });
    }
    let truth = TrueMode::new(system, mode, &numbers, interrupt)?;
    let balanced = balanced_motions(mode, &truth, &numbers)?;
    let formula = formula_at(mode, &truth, &numbers, &balanced)?;
    let motions = truth.followed_to(size, mode.number, amplitude)?;
    let Some((_, whole)) = motions.last().cloned() else {
        return Err(VerificationError::NoMode { number: mode.number, amplitude, reached: 0.0 });
    };
    let frequency = Some(formula.frequency_squared.sqrt()).filter(|omega| *omega > 0.0);
    let error = |frequency: f64, motion: &Motion| frequency / motion.frequency() - 1.0;
    let relative_error = frequency.map(|frequency| error(frequency, &whole));
    let energy = Energy::new(&system.equations, &at.split(&system.equations.parameters).0);
    let count = system.equations.coordinates.len();
    let mut errors = Vec::new();
    let linear = Some(truth.linear_frequency);
    let mut backbone = vec![BackbonePoint {
        amplitude: 0.0,
        frequency: linear,
        true_frequency: truth.linear_frequency,
        energy: energy.as_ref().map(|_| 0.0),
    }];
    for (part, motion) in &motions {
        let mut smaller = numbers.clone();
        smaller.insert(amplitude, part * size);
        let frequency = formula_at(mode, &truth, &smaller, &balanced)?.frequency_squared.sqrt();
        errors.push((*part, error(frequency, motion)));
        let start = motion.unknowns.iter().take(count).copied();
        let start: Vec<f64> = start.chain(std::iter::repeat_n(0.0, count)).collect();
        let energy = energy.as_ref().map(|energy| energy.over(&vec![0.0; 2 * count], &start));
        backbone.push(BackbonePoint {
            amplitude: part * size,
            frequency: Some(frequency).filter(|omega| *omega > 0.0),
            true_frequency: motion.frequency(),
            energy: energy.filter(|energy| energy.is_finite()),
        });
    }
    let by_formula: Vec<Vec<f64>> = (0..=POINTS)
        .map(|index| {
            let theta = PI * index as f64 / POINTS as f64;
            formula.motion.iter().map(|series| series.evaluate(theta)).collect()
        })
        .collect();
    let (mut largest, mut deviation) = (0.0_f64, 0.0_f64);
    for (formula, truth) in by_formula.iter().zip(&whole.path) {
        for (formula, truth) in formula.iter().zip(truth) {
            largest = largest.max(truth.abs());
            deviation = deviation.max((formula - truth).abs());
        }
    }
    let coefficients = mode.balance.as_ref().map_or(vec![], |balance| {
        let harmonics = formula.motion.iter().flat_map(|series| {
            balance.harmonics.iter().map(|&harmonic| series.cosine(harmonic).evaluate(0.0))
        });
        balance.coefficients.iter().flatten().copied().zip(harmonics).collect()
    });
    Ok(JudgedMode {
        law: law(mode, &numbers)?,
        coefficients,
        backbone,
        at: at.clone(),
        tolerance,
        frequency,
        true_frequency: whole.frequency(),
        relative_error,
        max_deviation: deviation / largest,
        near: mode.near_at(system, &at.split(&system.equations.parameters).0),
        slope: slope(&errors),
        paths: [by_formula, whole.path],
        verdict: Verdict::from_passed(relative_error.is_some_and(|error| error.abs() <= tolerance)),
    })
}

/// omega of the true motions of a mode at these amplitudes, of a system with numbers for all parameters.
///
/// # Errors
/// [`VerificationError`] where no true motion is found up to the largest amplitude.
pub(crate) fn mode_frequencies(
    system: &FreeSystem,
    mode: &NonlinearMode,
    amplitudes: &[f64],
) -> Result<Vec<f64>, VerificationError> {
    /// The motions that are known around an amplitude, through which its guess is interpolated.
    const AROUND: usize = 4;
    /// The part of the largest amplitude below which the frequency is that of the linear mode and a term in
    /// a^2, whose error is of the fourth power.
    const SMALL: f64 = 1e-3;
    let symbol = mode.amplitude.symbol();
    let largest = amplitudes.iter().copied().fold(0.0, f64::max);
    let numbers = BTreeMap::from([(symbol, largest)]);
    let truth = TrueMode::new(system, mode, &numbers, Interrupt::default())?;
    let known = truth.followed_to(largest, mode.number, symbol)?;
    let near = |part: f64| {
        let mut nearest: Vec<&(f64, Motion)> = known.iter().collect();
        nearest.sort_by(|one, other| (one.0 - part).abs().total_cmp(&(other.0 - part).abs()));
        nearest.truncate(AROUND);
        let mut guess = DVector::zeros(truth.shape.len() + 1);
        for (at, motion) in &nearest {
            let others = nearest.iter().map(|(other, _)| other).filter(|other| *other != at);
            let weight: f64 = others.map(|other| (part - other) / (at - other)).product();
            guess += &motion.unknowns * weight;
        }
        let none = VerificationError::NoMode {
            number: mode.number,
            amplitude: symbol,
            reached: part * largest,
        };
        let motion = truth.motion_near(guess, part * largest);
        motion.map(|motion| motion.frequency()).ok_or(none)
    };
    // omega = omega_0 + c a^2 + ... at amplitudes whose motions are lost in rounding.
    let bend = near(SMALL)? - truth.linear_frequency;
    let found = par_map(amplitudes, |&amplitude| match amplitude / largest {
        part if part < SMALL => Ok(truth.linear_frequency + bend * (part / SMALL).powi(2)),
        part => near(part),
    });
    found.into_iter().collect()
}

/// The coefficients of `omega^2` in powers of the amplitude.
fn law(
    mode: &NonlinearMode,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Vec<f64>, VerificationError> {
    let amplitude = mode.amplitude.symbol();
    if mode.balance.is_some() || mode.approximant.is_some() {
        return Ok(vec![]);
    }
    // The value of each term where the amplitude is one is its coefficient.
    let unit = numbers.iter().map(|(name, value)| (*name, *value)).chain([(amplitude, 1.0)]);
    let values = symbol_values(mode, &unit.collect())?;
    let mut coefficients = Vec::new();
    for (monomial, number) in mode.frequency_squared.terms() {
        let power = usize::try_from(monomial.exponent(amplitude)).unwrap_or(0);
        let term = Polynomial::term(monomial.clone(), number.clone());
        let term = term.evaluate(|name| values.get(&name).copied());
        coefficients.resize(coefficients.len().max(power + 1), 0.0);
        coefficients[power] += term.map_err(|name| VerificationError::Missing(vec![name]))?;
    }
    Ok(coefficients)
}

/// The exponent of an error from its values at rising parts of an amplitude: from the smallest part at
/// which rounding does not hide it and the one that is nearest to twice that; `None` where the next pair
/// has another exponent, as where the error changes its sign.
fn slope(errors: &[(f64, f64)]) -> Option<f64> {
    /// Shooting is exact to some 1e-13.
    const SMALLEST: f64 = 2e-11;
    /// The largest difference between two exponents.
    const ALIKE: f64 = 1.5;
    let seen: Vec<(f64, f64)> = errors
        .iter()
        .map(|(part, error)| (*part, error.abs()))
        .filter(|(_, error)| *error > SMALLEST && error.is_finite())
        .collect();
    let twice = |from: (f64, f64)| {
        let apart = |own: &(f64, f64)| (own.0 / (2.0 * from.0)).ln().abs();
        let near = seen.iter().copied().filter(|own| apart(own) < 0.3);
        near.min_by(|one, other| apart(one).total_cmp(&apart(other)))
    };
    let of = |(small, large): ((f64, f64), (f64, f64))| {
        (large.1 / small.1).ln() / (large.0 / small.0).ln()
    };
    let mut pairs = seen.iter().filter_map(|own| Some((*own, twice(*own)?)));
    let first = pairs.next()?;
    let next = twice(first.1).map(|beyond| of((first.1, beyond)));
    let slope = of(first);
    next.is_none_or(|next| (next - slope).abs() < ALIKE).then_some(slope)
}

/// The values as numbers.
pub(super) fn checked(
    system: &FreeSystem,
    amplitude: Symbol,
    at: &Values,
) -> Result<BTreeMap<Symbol, f64>, VerificationError> {
    let mut known = system.equations.parameters.clone();
    known.push(amplitude);
    let numbers = at.numbers();
    if let Some(name) = numbers.keys().find(|name| !known.contains(name)) {
        return Err(match system.equations.coordinates.contains(name) {
            true => VerificationError::Coordinate { name: *name, amplitude },
            false => VerificationError::Unknown { name: *name, known },
        });
    }
    known.retain(|name| !numbers.contains_key(name));
    match known.is_empty() {
        true => Ok(numbers),
        false => Err(VerificationError::Missing(known)),
    }
}

/// The values of all symbols of the formulas.
fn symbol_values(
    mode: &NonlinearMode,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<BTreeMap<Symbol, f64>, VerificationError> {
    let pi = Symbol::new("pi");
    let value_of =
        |name: Symbol| numbers.get(&name).copied().or_else(|| (name == pi).then_some(PI));
    let defined = defined_values(&mode.definitions, &value_of).map_err(|name| {
        match mode.definitions.iter().find(|definition| definition.symbol == name) {
            Some(definition) => VerificationError::NoValue {
                number: mode.number,
                name,
                meaning: definition.meaning.clone(),
            },
            None => VerificationError::Missing(vec![name]),
        }
    })?;
    Ok(numbers
        .iter()
        .map(|(name, value)| (*name, *value))
        .chain(defined)
        .chain([(pi, PI)])
        .collect())
}

/// The first divisor of the formula that is zero at the values, within rounding; `None` if there is none.
fn vanishing_divisor(mode: &NonlinearMode, numbers: &BTreeMap<Symbol, f64>) -> Option<Symbol> {
    let rounded = |value: f64| (value, f64::EPSILON * value.abs());
    let mut known: BTreeMap<Symbol, (f64, f64)> =
        numbers.iter().map(|(name, value)| (*name, rounded(*value))).collect();
    known.insert(Symbol::new("pi"), rounded(PI));
    let harmonics = mode.motion.iter().flat_map(|series| series.harmonics());
    let coefficients: Vec<Polynomial> = harmonics
        .flat_map(|(_, cosine, sine)| [cosine, sine])
        .chain([mode.frequency_squared.clone()])
        .collect();
    let divides = |name: Symbol| {
        let least = coefficients.iter().filter_map(|own| own.exponent_range(name));
        least.into_iter().any(|(least, _)| least < 0)
    };
    for Definition { symbol, meaning } in &mode.definitions {
        let (value, error) = meaning.evaluate_rounded(&|name| known.get(&name).copied())?;
        if value.abs() <= error && divides(*symbol) {
            return Some(*symbol);
        }
        known.insert(*symbol, (value, error));
    }
    None
}

/// The motions by a balance of harmonics up to an amplitude; none of a series.
fn balanced_motions(
    mode: &NonlinearMode,
    truth: &TrueMode,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Vec<(f64, ModeInNumbers)>, VerificationError> {
    let Some(balance) = &mode.balance else { return Ok(vec![]) };
    let amplitude = mode.amplitude.symbol();
    let size = numbers[&amplitude];
    let start = BalanceStart {
        shape: &truth.shape,
        frequency_squared: truth.linear_frequency.powi(2),
        along: mode.along,
    };
    let found = balance.followed_to(start, &symbol_values(mode, numbers)?, size);
    let found = found.map_err(|reached| VerificationError::NoBalance {
        number: mode.number,
        amplitude,
        reached: reached * size,
    })?;
    Ok(found.into_iter().map(|(part, motion)| (part * size, motion)).collect())
}

/// The mode in numbers; `balanced` are the motions that are known of a balance.
fn formula_at(
    mode: &NonlinearMode,
    truth: &TrueMode,
    numbers: &BTreeMap<Symbol, f64>,
    balanced: &[(f64, ModeInNumbers)],
) -> Result<ModeInNumbers, VerificationError> {
    let values = symbol_values(mode, numbers)?;
    if mode.balance.is_some() {
        let size = numbers[&mode.amplitude.symbol()];
        let known = balanced.iter().find(|(amplitude, _)| *amplitude == size);
        if let Some((_, motion)) = known {
            return Ok(motion.clone());
        }
        let own = balanced_motions(mode, truth, numbers)?;
        let nothing = VerificationError::NoBalance {
            number: mode.number,
            amplitude: mode.amplitude.symbol(),
            reached: 0.0,
        };
        return own.into_iter().last().map(|(_, motion)| motion).ok_or(nothing);
    }
    let value_of = |name: Symbol| values.get(&name).copied();
    let missing = |name| VerificationError::Missing(vec![name]);
    let frequency_squared = match &mode.approximant {
        Some(approximant) => approximant.value.evaluate(&values).unwrap_or(f64::NAN),
        None => mode.frequency_squared.evaluate(value_of).map_err(missing)?,
    };
    let motion = mode.motion.iter().map(|series| {
        series.map(Doubles, |coefficient, _| coefficient.evaluate(value_of).unwrap_or(f64::NAN))
    });
    let motion: Vec<FourierSeries<Doubles>> = motion.collect();
    Ok(ModeInNumbers { frequency_squared, motion })
}

/// The equations with numbers, and the definition of the amplitude.
pub(super) struct TrueMode {
    solver: Solver,
    /// v.
    shape: Vec<f64>,
    /// `u^T M/(u^T M v)`.
    projection: Vec<f64>,
    linear_frequency: f64,
    along: usize,
    amplitude: AmplitudeConvention,
    interrupt: Interrupt,
}

/// The equations with numbers.
fn solver(
    system: &FreeSystem,
    values: &BTreeMap<Symbol, f64>,
    interrupt: Interrupt,
) -> Result<Solver, VerificationError> {
    let rates = &system.equations.rates;
    let options = SystemOptions { step_limit: 20_000, interrupt, ..SystemOptions::default() };
    Ok(System::new(&rates.states, Symbol::new("t"), &rates.right, values)
        .map_err(|error| VerificationError::NoSystem(error.to_string()))?
        .solver(&[], &options))
}

impl TrueMode {
    fn new(
        system: &FreeSystem,
        mode: &NonlinearMode,
        numbers: &BTreeMap<Symbol, f64>,
        interrupt: Interrupt,
    ) -> Result<Self, VerificationError> {
        let values = symbol_values(mode, numbers)?;
        let constants = defined_values(&system.constants, &|name| values.get(&name).copied())
            .map_err(|name| VerificationError::Missing(vec![name]))?;
        let value_of = |name: Symbol| {
            let constant = constants.iter().find(|(known, _)| *known == name);
            values.get(&name).copied().or_else(|| constant.map(|(_, value)| *value))
        };
        let number = |polynomial: &Polynomial| {
            polynomial.evaluate(value_of).map_err(|name| VerificationError::Missing(vec![name]))
        };
        let all = |entries: &[Polynomial]| -> Result<Vec<f64>, VerificationError> {
            entries.iter().map(number).collect()
        };
        let (shape, projection) = (all(&mode.linear.shape)?, all(&mode.linear.modal)?);
        Ok(Self {
            solver: solver(system, &values, interrupt)?,
            shape,
            projection,
            linear_frequency: number(&mode.linear.square)?.sqrt(),
            along: mode.along,
            amplitude: mode.amplitude,
            interrupt,
        })
    }

    /// The true motions of a system whose amplitude is the start of the first coordinate.
    pub(super) fn from_start(
        system: &FreeSystem,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<Self, VerificationError> {
        let count = system.equations.coordinates.len();
        let values = numbers.iter().map(|(name, value)| (*name, *value));
        let values = values.chain([(Symbol::new("pi"), PI)]).collect();
        Ok(Self {
            solver: solver(system, &values, Interrupt::default())?,
            shape: vec![0.0; count],
            projection: vec![0.0; count],
            linear_frequency: f64::NAN,
            along: 0,
            amplitude: AmplitudeConvention::Initial,
            interrupt: Interrupt::default(),
        })
    }

    /// The frequency of the true motion near one with these starts of the coordinates and this
    /// frequency, its first coordinate starting there; `None` if there is none.
    pub(super) fn frequency_near(&self, start: &[f64], frequency: f64) -> Option<f64> {
        let guess = start.iter().copied().chain([PI / frequency]);
        let guess = DVector::from_iterator(start.len() + 1, guess);
        Some(self.motion_near(guess, *start.first()?)?.frequency())
    }

    /// The motions at parts of an amplitude up to all of it, followed from the linear mode.
    fn followed_to(
        &self,
        amplitude: f64,
        number: usize,
        symbol: Symbol,
    ) -> Result<Vec<(f64, Motion)>, VerificationError> {
        let count = self.shape.len();
        let linear = |part: f64| {
            let start = self.shape.iter().map(|entry| entry * part * amplitude);
            DVector::from_iterator(count + 1, start.chain([PI / self.linear_frequency]))
        };
        let near = |guess: DVector<f64>, part: f64| self.motion_near(guess, part * amplitude);
        in_amplitude(linear, near, |motion| &motion.unknowns).map_err(|reached| {
            match self.interrupt.is_requested() {
                true => VerificationError::Interrupted,
                false => VerificationError::NoMode {
                    number,
                    amplitude: symbol,
                    reached: reached * amplitude,
                },
            }
        })
    }

    /// The motion that Newton's method finds from a guess; `None` if it does not converge.
    fn motion_near(&self, guess: DVector<f64>, amplitude: f64) -> Option<Motion> {
        const ITERATIONS: usize = 12;
        const SMALL: f64 = 1e-12;
        let count = self.shape.len();
        let mut unknowns = guess;
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let (rest, path) = self.residual(&unknowns, amplitude)?;
            let mut slopes = DMatrix::zeros(count + 1, count + 1);
            for column in 0..=count {
                let scale = if column < count { amplitude.abs() } else { unknowns[count] };
                let change = 1e-6 * scale;
                let [after, before] = [1.0, -1.0].map(|sign| {
                    let mut moved = unknowns.clone();
                    moved[column] += sign * change;
                    self.residual(&moved, amplitude).map(|(residual, _)| residual)
                });
                slopes.set_column(column, &((after? - before?) / (2.0 * change)));
            }
            let step = slopes.lu().solve(&rest)?;
            let relative = (0..count)
                .map(|index| (step[index] / amplitude).abs())
                .chain([(step[count] / unknowns[count]).abs()])
                .fold(0.0, f64::max);
            if !relative.is_finite() {
                return None;
            }
            // Converged, or as far as rounding lets it.
            if relative < SMALL || relative < 1e-9 && relative >= 0.5 * last {
                return Some(Motion { unknowns, path });
            }
            // A step of this size leads to another motion.
            if relative > 0.5 {
                return None;
            }
            unknowns -= step;
            last = relative;
        }
        None
    }

    /// The velocities at the end of half a period, each over the size of velocities, and the error of
    /// the amplitude over it; and the coordinates on the way.
    fn residual(
        &self,
        unknowns: &DVector<f64>,
        amplitude: f64,
    ) -> Option<(DVector<f64>, Vec<Vec<f64>>)> {
        let count = self.shape.len();
        let half = unknowns[count];
        if !(half > 0.0 && half.is_finite()) {
            return None;
        }
        let start: Vec<f64> =
            unknowns.iter().take(count).copied().chain(std::iter::repeat_n(0.0, count)).collect();
        let path = self.solver.solve([0.0, half], &start).ok()?;
        if path.reason() != PathEnd::Reached {
            return None;
        }
        let times: Vec<f64> =
            (0..=POINTS).map(|index| half * index as f64 / POINTS as f64).collect();
        let mut columns = vec![Vec::new(); 2 * count];
        path.sample(&times, &mut Vec::new(), &mut columns);
        let end = path.states_at(half)?;
        let places: Vec<Vec<f64>> = (0..=POINTS)
            .map(|index| {
                let place = columns.iter().take(count).map(|column| column.get(index).copied());
                place.collect::<Option<Vec<f64>>>()
            })
            .collect::<Option<_>>()?;
        let measured = match self.amplitude {
            AmplitudeConvention::Initial => unknowns[self.along],
            AmplitudeConvention::FirstHarmonic => {
                let waves = places.iter().enumerate().map(|(index, place)| {
                    let weight = if index == 0 || index == POINTS { 0.5 } else { 1.0 };
                    let modal: f64 =
                        self.projection.iter().zip(place).map(|(entry, q)| entry * q).sum();
                    weight * modal * (PI * index as f64 / POINTS as f64).cos()
                });
                2.0 * waves.sum::<f64>() / POINTS as f64
            }
        };
        let speed = amplitude * TAU / half;
        let mut rest = DVector::zeros(count + 1);
        for index in 0..count {
            rest[index] = end[count + index] / speed;
        }
        rest[count] = measured / amplitude - 1.0;
        Some((rest, places))
    }
}

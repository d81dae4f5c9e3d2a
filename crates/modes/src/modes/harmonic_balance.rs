//! Normal modes by balance of several harmonics, solved by numbers at an amplitude.
//!
//! ```text
//! q_i = sum_k q_ik cos k theta,   k = 1, 3, ..., 2n-1 where every force is odd, 0, 1, ..., n otherwise,   theta = omega t
//! (2/pi) int_0^pi R_i cos k theta dtheta = 0,   R = M q'' + K q + f(q, q', q'')                    (k = 0 counts half)
//! sum_k q_jk = A,   j the first coordinate that moves in the linear mode
//! ```
//!
//! References: M. Krack, J. Gross, *Harmonic Balance for Nonlinear Vibration Problems*, Springer 2019,
//! chapters 2 and 5 (nonlinear modes). Integrals are sums over equal steps, exact for polynomials of
//! degree d beyond `(d + 1) k/2` steps, and refined until two agree for other forces.
//!
//! Cost: for N coordinates, H harmonics and m samples `O(m (N H)^2 + (N H)^3)` for each of Newton's
//! steps, some thirty of them from the linear mode to an amplitude.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};
use num_traits::{One, Zero};

use super::free_system::ForceTerm;
use super::{FreeSystem, LinearShape, ModeError, NonlinearMode};
use crate::exact::polynomial::Monomial;
use crate::exact::{Doubles, POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::{CompiledList, Expr, ExprError};
use crate::method::{MOST_HARMONICS, harmonics};
use crate::numeric::continuation::in_amplitude;
use crate::numeric::ode::newton::{Progress, newton};
use crate::series::FourierSeries;
use crate::solution::AmplitudeConvention;
use crate::symbol::letters::{AMPLITUDE, FREQUENCY};
use crate::symbol::{Symbol, fresh};

/// The highest degree of a polynomial force whose balance is written out.
const HIGHEST_DEGREE: u32 = 9;

/// The longest system that is written out, in terms.
const MOST_TERMS: usize = 2000;

/// The balance of several harmonics of every coordinate.
#[derive(Clone, Debug)]
pub struct ModeBalance {
    /// The harmonics.
    pub harmonics: Vec<usize>,
    /// The coefficients of each coordinate, one for each harmonic.
    pub coefficients: Vec<Vec<Symbol>>,
    /// The equations, each of them equal to zero, the last that of the amplitude; empty where the
    /// forces are no polynomials, or the equations too long to be read.
    pub equations: Vec<Expr>,
    /// The degree of the forces; `None` if they are no polynomials.
    degree: Option<usize>,
    /// Coordinate, velocity and acceleration of each coordinate.
    states: Vec<Symbol>,
    /// The left side of each equation of motion less its right side, functions of these.
    residuals: Vec<Expr>,
}

/// A mode in numbers.
#[derive(Clone, Debug)]
pub struct ModeInNumbers {
    /// omega^2.
    pub frequency_squared: f64,
    /// The motion of each coordinate.
    pub motion: Vec<FourierSeries<Doubles>>,
}

/// The linear mode from which a balance is followed.
#[derive(Clone, Copy, Debug)]
pub struct BalanceStart<'a> {
    /// The shape of the linear mode.
    pub shape: &'a [f64],
    /// The square of its frequency.
    pub frequency_squared: f64,
    /// The coordinate whose start is the amplitude.
    pub along: usize,
}

/// The balance of a number of harmonics of every coordinate of a system, and the motion in its
/// unknowns.
///
/// # Errors
/// [`ModeError`] for forces that are odd in the velocities, and for a number of harmonics beyond the
/// limit.
pub(super) fn balance(
    system: &mut FreeSystem,
    count: u32,
) -> Result<(ModeBalance, Vec<FourierSeries<Polynomials>>), ModeError> {
    if !(1..=MOST_HARMONICS).contains(&count) {
        return Err(ModeError::Harmonics(count, MOST_HARMONICS));
    }
    let residuals = system.residuals();
    let harmonics = harmonics(count, is_odd(system, &residuals)?);
    let coefficients = coefficient_names(system, &harmonics);
    let series = |names: &Vec<Symbol>| {
        let mut cosine = vec![Polynomial::zero(); harmonics.last().map_or(0, |last| last + 1)];
        for (&k, &name) in harmonics.iter().zip(names) {
            cosine[k] = Polynomial::symbol(name);
        }
        FourierSeries::from_parts(POLYNOMIALS, cosine, vec![])
    };
    let motion: Vec<FourierSeries<Polynomials>> = coefficients.iter().map(series).collect();
    let force = system.force_terms(HIGHEST_DEGREE + 2)?;
    let degree = force.iter().flatten().map(ForceTerm::degree).max().unwrap_or(1);
    let degree = (degree <= HIGHEST_DEGREE as usize).then_some(degree);
    let equations = match degree {
        Some(degree) => written_out(system, &force, degree, &harmonics, &motion),
        None => None,
    };
    let states = system.equations.coordinates.iter();
    let states = states.flat_map(|name| [*name, name.derivative(), name.derivative().derivative()]);
    let balance = ModeBalance {
        harmonics,
        coefficients,
        equations: equations.unwrap_or_default(),
        degree,
        states: states.collect(),
        residuals,
    };
    Ok((balance, motion))
}

/// A mode by the balance, in its unknowns.
pub(super) fn mode_of_balance(
    number: usize,
    linear: LinearShape,
    mut balance: ModeBalance,
    motion: Vec<FourierSeries<Polynomials>>,
) -> NonlinearMode {
    let along = linear.along();
    if !balance.equations.is_empty() {
        let start = balance.coefficients[along].iter().map(|&name| Expr::from(name));
        balance.equations.push(Expr::sum(start) - Expr::from(AMPLITUDE));
    }
    NonlinearMode {
        number,
        order: u32::try_from(balance.harmonics.len()).unwrap_or(u32::MAX),
        amplitude: AmplitudeConvention::Initial,
        frequency_squared: Polynomial::term(Monomial::power_of(FREQUENCY, 2), Rational::one()),
        approximant: None,
        balance: Some(balance),
        motion,
        along,
        linear,
        lines: vec![],
        near: vec![],
        definitions: vec![],
        rounded: false,
        derivation: vec![],
    }
}

/// Whether every equation changes its sign with all coordinates.
fn is_odd(system: &FreeSystem, residuals: &[Expr]) -> Result<bool, ExprError> {
    let names = system.equations.coordinates.iter();
    let names = names.flat_map(|name| [*name, name.derivative(), name.derivative().derivative()]);
    let mirrored: BTreeMap<Symbol, Expr> = names.map(|name| (name, -Expr::from(name))).collect();
    for residual in residuals {
        if !(residual + &residual.substitute_all(&mirrored)?).expand()?.is_zero() {
            return Ok(false);
        }
    }
    Ok(true)
}

/// `x1`, `x3`, ... of each coordinate; other names where the equations use one of these.
fn coefficient_names(system: &FreeSystem, harmonics: &[usize]) -> Vec<Vec<Symbol>> {
    let mut taken = system.names();
    let mut names_of = |coordinate: &Symbol| -> Vec<Symbol> {
        let stem = coordinate.written();
        let gap = if stem.ends_with(|last: char| last.is_ascii_digit()) { "_" } else { "" };
        let name = |k: &usize| {
            let name = fresh(&format!("{stem}{gap}{k}"), &taken);
            taken.push(name);
            name
        };
        harmonics.iter().map(name).collect()
    };
    system.equations.coordinates.iter().map(&mut names_of).collect()
}

/// The balance of every harmonic of every equation; `None` where that is too long.
fn written_out(
    system: &FreeSystem,
    force: &[Vec<ForceTerm>],
    degree: usize,
    harmonics: &[usize],
    motion: &[FourierSeries<Polynomials>],
) -> Option<Vec<Expr>> {
    let terms: usize = force.iter().map(Vec::len).sum();
    let exponent = u32::try_from(degree).unwrap_or(u32::MAX);
    if terms.saturating_mul(harmonics.len().saturating_pow(exponent)) > MOST_TERMS {
        return None;
    }
    let constant = |entry: &Polynomial| FourierSeries::constant(POLYNOMIALS, entry.clone());
    let squared = Polynomial::term(Monomial::power_of(FREQUENCY, 2), Rational::one());
    // The derivatives in theta of each coordinate.
    let derivatives: Vec<[FourierSeries<Polynomials>; 3]> = motion
        .iter()
        .map(|series| {
            let velocity = series.derivative();
            let acceleration = velocity.derivative();
            [series.clone(), velocity, acceleration]
        })
        .collect();
    let mut equations = Vec::new();
    for (row, terms) in force.iter().enumerate() {
        let mut along = FourierSeries::zero(POLYNOMIALS);
        for (column, [place, _, acceleration]) in derivatives.iter().enumerate() {
            let stiffness = constant(&system.stiffness[row][column]).product(place);
            let inertia = system.mass[row][column].product(&squared);
            along = along.sum(&stiffness).sum(&constant(&inertia).product(acceleration));
        }
        for term in terms {
            let rate = i32::try_from(2 * term.rates()).unwrap_or(i32::MAX);
            let factor = term.coefficient.times_monomial(&Monomial::power_of(FREQUENCY, rate));
            let powers = term.powers.iter();
            let product = powers.fold(constant(&factor), |product, (coordinate, primes, power)| {
                product.product(&derivatives[*coordinate][*primes].power(*power))
            });
            along = along.sum(&product);
        }
        for &k in harmonics {
            let harmonic = along.cosine(k);
            let (numerator, denominator) = harmonic.mean();
            let divisor = Rational::from_integer(denominator.clone());
            equations.push(Expr::from(&numerator.map(|value| value / &divisor)));
        }
    }
    Some(equations)
}

impl ModeBalance {
    /// The harmonics, separated by commas.
    pub fn harmonics_in_words(&self) -> String {
        self.harmonics.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
    }

    /// The unknowns: omega and the coefficients.
    pub fn unknowns(&self) -> Vec<Symbol> {
        std::iter::once(FREQUENCY).chain(self.coefficients.iter().flatten().copied()).collect()
    }

    /// The motions at parts of an amplitude up to all of it, followed from the linear mode.
    ///
    /// # Errors
    /// The part that was reached, where a balance turns back or has no motion beyond.
    pub fn followed_to(
        &self,
        start: BalanceStart,
        values: &BTreeMap<Symbol, f64>,
        amplitude: f64,
    ) -> Result<Vec<(f64, ModeInNumbers)>, f64> {
        let forces = Forces::new(self, values).ok_or(0.0)?;
        let (harmonics, count) = (self.harmonics.len(), self.coefficients.len());
        let first = self.harmonics.iter().position(|k| *k == 1).ok_or(0.0)?;
        let linear = |part: f64| {
            let mut guess = DVector::zeros(count * harmonics + 1);
            for (index, entry) in start.shape.iter().enumerate() {
                guess[index * harmonics + first] = entry * part * amplitude;
            }
            guess[count * harmonics] = start.frequency_squared;
            guess
        };
        let near =
            |guess: DVector<f64>, part: f64| forces.solved(guess, start.along, part * amplitude);
        let found = in_amplitude(linear, near, |known| known)?;
        let motion = |(part, unknowns): (f64, DVector<f64>)| {
            let series = (0..count).map(|index| {
                let mut cosine = vec![0.0; self.harmonics.last().map_or(0, |last| last + 1)];
                for (place, &k) in self.harmonics.iter().enumerate() {
                    let own = unknowns[index * harmonics + place];
                    // What is left of zero by rounding.
                    cosine[k] =
                        if own.abs() < 1e-14 * (part * amplitude).abs() { 0.0 } else { own };
                }
                FourierSeries::from_parts(Doubles, cosine, vec![])
            });
            let frequency_squared = unknowns[count * harmonics];
            (part, ModeInNumbers { frequency_squared, motion: series.collect() })
        };
        Ok(found.into_iter().map(motion).collect())
    }
}

/// The equations of motion in numbers, with their slopes in coordinates, velocities, accelerations.
struct Forces<'a> {
    balance: &'a ModeBalance,
    compiled: CompiledList,
    /// The values of the letters, which are arguments behind the states.
    letters: Vec<f64>,
}

impl<'a> Forces<'a> {
    fn new(balance: &'a ModeBalance, values: &BTreeMap<Symbol, f64>) -> Option<Self> {
        let mut all = balance.residuals.clone();
        for residual in &balance.residuals {
            for state in &balance.states {
                all.push(residual.differentiate(*state).ok()?);
            }
        }
        let arguments: Vec<Symbol> = balance.states.iter().chain(values.keys()).copied().collect();
        let compiled = CompiledList::new(&all, &arguments).ok()?;
        Some(Self { balance, compiled, letters: values.values().copied().collect() })
    }

    /// The motion of an amplitude near a guess, with as many steps in the integrals as it takes;
    /// `None` if Newton's method does not find one.
    fn solved(&self, guess: DVector<f64>, along: usize, amplitude: f64) -> Option<DVector<f64>> {
        /// Steps of half a period: the first number of them and the largest, beside what harmonics of
        /// a polynomial need.
        const FIRST: usize = 32;
        const MOST: usize = 8192;
        /// The largest relative change by a refinement that is accepted.
        const ENOUGH: f64 = 1e-11;
        let highest = self.balance.harmonics.last().map_or(1, |last| last + 1);
        if let Some(degree) = self.balance.degree {
            return self.solved_with((degree + 1) * highest, guess, along, amplitude);
        }
        let mut steps = FIRST.max(4 * highest);
        let mut found = self.solved_with(steps, guess, along, amplitude)?;
        loop {
            steps *= 2;
            let finer = self.solved_with(steps, found.clone(), along, amplitude)?;
            let change = self.relative(&(&finer - &found), &finer, amplitude);
            match change < ENOUGH {
                true => return Some(finer),
                false if steps >= MOST => return None,
                false => found = finer,
            }
        }
    }

    /// The motion with integrals over this number of steps.
    fn solved_with(
        &self,
        steps: usize,
        guess: DVector<f64>,
        along: usize,
        amplitude: f64,
    ) -> Option<DVector<f64>> {
        const ITERATIONS: usize = 25;
        const SMALL: f64 = 1e-13;
        let mut last = f64::INFINITY;
        newton(
            guess,
            ITERATIONS,
            |unknowns| self.balances(steps, unknowns, along, amplitude),
            |unknowns, step| {
                let relative = self.relative(step, unknowns, amplitude);
                // Converged, or as far as rounding lets it.
                let settled = relative < SMALL || relative < 1e-10 && relative >= 0.5 * last;
                last = relative;
                match settled {
                    true => Progress::Settled,
                    // A step of this size leads to another motion.
                    false if relative.is_nan() || relative > 0.5 => Progress::Lost,
                    false => Progress::Going,
                }
            },
        )
    }

    /// The size of a change, of coefficients over the amplitude and of omega^2 over itself.
    fn relative(&self, change: &DVector<f64>, unknowns: &DVector<f64>, amplitude: f64) -> f64 {
        let last = change.len() - 1;
        let of_frequency = (change[last] / unknowns[last]).abs();
        let parts = change.iter().take(last).map(|part| (part / amplitude).abs());
        parts.fold(of_frequency, |largest, part| if part > largest { part } else { largest })
    }

    /// The equations and their slopes in the unknowns.
    fn balances(
        &self,
        steps: usize,
        unknowns: &DVector<f64>,
        along: usize,
        amplitude: f64,
    ) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let harmonics = &self.balance.harmonics;
        let (count, width) = (self.balance.coefficients.len(), harmonics.len());
        let last = count * width;
        let square = unknowns[last];
        if !(square > 0.0 && square.is_finite()) {
            return None;
        }
        let omega = square.sqrt();
        let mut residual = DVector::zeros(last + 1);
        let mut slopes = DMatrix::zeros(last + 1, last + 1);
        let mut arguments = vec![0.0; 3 * count];
        arguments.extend(&self.letters);
        let (mut work, mut values) = (vec![], vec![0.0; count + 3 * count * count]);
        for step in 0..=steps {
            let theta = PI * step as f64 / steps as f64;
            let weight = if step == 0 || step == steps { 1.0 } else { 2.0 } / steps as f64;
            let waves: Vec<(f64, f64, f64)> = harmonics
                .iter()
                .map(|&k| k as f64 * theta)
                .map(f64::sin_cos)
                .zip(harmonics)
                .map(|((sine, cosine), &k)| {
                    (cosine, -omega * k as f64 * sine, -square * (k * k) as f64 * cosine)
                })
                .collect();
            for index in 0..count {
                let own = unknowns.as_slice()[index * width..].iter().zip(&waves);
                let state = own.fold([0.0; 3], |[q, v, a], (part, wave)| {
                    [q + part * wave.0, v + part * wave.1, a + part * wave.2]
                });
                arguments[3 * index..3 * index + 3].copy_from_slice(&state);
            }
            self.compiled.call(&arguments, &mut work, &mut values);
            for row in 0..count {
                let own = &values[count + 3 * count * row..][..3 * count];
                // The slope in omega^2: velocities are proportional to its root.
                let of_square: f64 = (0..count)
                    .map(|index| {
                        let [_, velocity, acceleration] =
                            [0, 1, 2].map(|n| arguments[3 * index + n]);
                        let [_, in_velocity, in_acceleration] =
                            [0, 1, 2].map(|n| own[3 * index + n]);
                        in_velocity * velocity / (2.0 * square)
                            + in_acceleration * acceleration / square
                    })
                    .sum();
                for (place, &k) in harmonics.iter().enumerate() {
                    let mean = if k == 0 { 0.5 } else { 1.0 };
                    let factor = mean * weight * (k as f64 * theta).cos();
                    let equation = row * width + place;
                    residual[equation] += factor * values[row];
                    slopes[(equation, last)] += factor * of_square;
                    for index in 0..count {
                        let [q, v, a] = [0, 1, 2].map(|n| factor * own[3 * index + n]);
                        if q == 0.0 && v == 0.0 && a == 0.0 {
                            continue;
                        }
                        for (column, wave) in waves.iter().enumerate() {
                            slopes[(equation, index * width + column)] +=
                                q * wave.0 + v * wave.1 + a * wave.2;
                        }
                    }
                }
            }
        }
        for column in 0..width {
            residual[last] += unknowns[along * width + column];
            slopes[(last, along * width + column)] = 1.0;
        }
        residual[last] -= amplitude;
        residual.iter().all(|part: &f64| part.is_finite()).then_some((residual, slopes))
    }
}

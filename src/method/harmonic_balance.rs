//! Harmonic balance: as many harmonics as wanted, each balanced.
//!
//! References: R. E. Mickens, *Truly Nonlinear Oscillations*, World Scientific 2010, chapter 3; M. Krack, J. Gross, *Harmonic
//! Balance for Nonlinear Vibration Problems*, Springer 2019, chapters 2 and 4 (sampling in time, continuation).
//!
//! ```text
//! x = sum_k a_k cos(k theta),   k = 1, 3, ..., 2n-1 for an odd force, 0, 1, ..., n otherwise,   A = sum_k a_k
//! -k^2 omega^2 a_k + c_k = 0,   c_k = (2/pi) int_0^pi f(x(theta)) cos(k theta) dtheta          (c_0 counts half)
//! J = -k^2 omega^2 delta_kj + (2/pi) int_0^pi f'(x) cos(k theta) cos(j theta) dtheta
//! ```
//!
//! One harmonic of an odd force is solved in closed form. Beyond that the system is printed, and solved by Newton's
//! iteration with the amplitude raised in steps from where one harmonic is enough. Sums over `N` points stand for the
//! integrals: exact for polynomials of degree `d` once `N > (d + 1) k/2`, and doubled until they settle otherwise.
//!
//! ```
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::HarmonicBalance), order: Some(2), ..Options::default() };
//! let system = solve(&duffing, &options)?.system.unwrap();
//! assert_eq!(system.equations.len(), 3); // two harmonics and A = a1 + a3
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use nalgebra::{DMatrix, DVector};
use num_traits::{One, Zero};

use super::iteration_perturbation::{horner, polynomial_coefficients};
use super::one_term::{conservative_force, integral_law, set_law, shared_integral, unsolved};
use super::{Options, Refusal};
use crate::conservative::is_odd;
use crate::conservative::projection::cosine_coefficient;
use crate::derivation::{Formula, Line};
use crate::exact::polynomial::Monomial;
use crate::exact::{Integer, Polynomial, Rational, Ring};
use crate::expr::{Expr, Function};
use crate::oscillator::Oscillator;
use crate::series::FourierSeries;
use crate::solution::{Method, Solution, System};
use crate::symbol::Symbol;

const METHOD: Method = Method::HarmonicBalance;

/// The most harmonics.
pub const MOST_HARMONICS: u32 = 100;

/// The longest system that is written out, in terms: fifteen harmonics of a cubic force. Beyond, nobody reads it.
const MOST_TERMS: usize = 3500;

/// The balance of so many harmonics, two by default.
///
/// # Errors
/// A force that is not conservative, by its term; no harmonics, or more than [`MOST_HARMONICS`].
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    let force = conservative_force(oscillator, options, METHOD)?;
    let order = options.order.unwrap_or(2);
    if order == 0 || order > MOST_HARMONICS {
        return Err(Refusal::HighestOrder {
            method: METHOD.title(),
            highest: MOST_HARMONICS,
        });
    }
    let odd = is_odd(&force, oscillator.coordinate)?;
    let mut solution = unsolved(oscillator, options, METHOD, order);
    if order == 1
        && odd
        && let Some(law) = shared_integral(oscillator, &force)
    {
        set_law(&mut solution, &law)?;
        solution.derivation = vec![Line::equation(oscillator.coordinate, solution.displacement.clone())];
        let law = integral_law(oscillator, &force, &solution)?;
        solution.derivation.extend(law);
        solution
            .validity
            .push("one harmonic: exact for a linear force, the first step beyond it otherwise".to_owned());
        return Ok(solution);
    }
    let harmonics = harmonics(order, odd);
    let names = coefficient_names(oscillator, &harmonics);
    let mut cosine = vec![Polynomial::zero(); harmonics.last().map_or(0, |last| last + 1)];
    for (&k, &name) in harmonics.iter().zip(&names) {
        cosine[k] = Polynomial::symbol(name);
    }
    solution.displacement = FourierSeries::from_parts(cosine, vec![], Integer::one());
    solution.derivation = projections(oscillator, &force, &harmonics, &names, &solution.displacement)?;
    let kept: Vec<String> = harmonics.iter().map(ToString::to_string).collect();
    match equations(oscillator, &force, &harmonics, &names, &solution.displacement)? {
        Some(equations) => {
            let unknowns = std::iter::once(Symbol::new("omega")).chain(names).collect();
            if equations
                .iter()
                .any(|equation| equation.contains_function(Function::Acos))
            {
                solution.validity.push("the arcs are written for a1 > 0".to_owned());
            }
            solution.system = Some(System { unknowns, equations });
        }
        None => {
            solution.by_quadrature = Some(solution.derivation.clone());
        }
    }
    solution.validity.push(format!(
        "harmonics {} balanced, those above left out; solved by numbers at an amplitude",
        kept.join(", ")
    ));
    Ok(solution)
}

/// The balance of each harmonic as an integral over the force along the motion.
fn projections(
    oscillator: &Oscillator,
    force: &Expr,
    harmonics: &[usize],
    names: &[Symbol],
    motion: &FourierSeries<Polynomial>,
) -> Result<Vec<Line>, Refusal> {
    /// Beyond so many harmonics one line stands for all.
    const MOST_LINES: usize = 8;
    let omega = Expr::symbol("omega").integer_power(2)?;
    let balance = |k: Expr, name: Expr, factor: i64| -> Result<Line, Refusal> {
        let integral = Formula::Integral {
            factor: Expr::divide(&Expr::from(factor), &Expr::pi())?,
            from: Expr::zero(),
            to: Expr::pi(),
            integrand: Box::new((force * &(&k * &Expr::symbol("theta")).cos()?).into()),
            variable: "theta".into(),
        };
        Ok(Line::equation(k.integer_power(2)? * &omega * name, integral))
    };
    let mut lines = vec![Line::equation(oscillator.coordinate, motion.clone())];
    if harmonics.len() <= MOST_LINES {
        for (&k, &name) in harmonics.iter().zip(names) {
            let factor = if k == 0 { 1 } else { 2 };
            lines.push(balance(Expr::from(k as i64), name.into(), factor)?.because(format!("harmonic {k}")));
        }
    } else {
        let kept: Vec<String> = harmonics.iter().map(ToString::to_string).collect();
        let letter = names.last().map_or("a", |name| name.name());
        let letter = letter.trim_end_matches(|digit: char| digit.is_ascii_digit() || digit == '_');
        let general = balance(Expr::symbol("k"), Expr::symbol(&format!("{letter}_k")), 2)?;
        lines.push(general.because(format!("harmonics k = {}", kept.join(", "))));
    }
    lines.push(Line::equation(
        "A",
        Expr::sum(names.iter().map(|name| Expr::from(*name))),
    ));
    Ok(lines)
}

/// The harmonics of an order.
fn harmonics(order: u32, odd: bool) -> Vec<usize> {
    let order = order as usize;
    match odd {
        true => (0..order).map(|n| 2 * n + 1).collect(),
        false => (0..=order).collect(),
    }
}

/// `a1`, `a3`, ...; another letter where the equation uses one of these.
fn coefficient_names(oscillator: &Oscillator, harmonics: &[usize]) -> Vec<Symbol> {
    let with =
        |letter: &str| -> Vec<Symbol> { harmonics.iter().map(|k| Symbol::new(&format!("{letter}{k}"))).collect() };
    let free = |names: &Vec<Symbol>| names.iter().all(|name| !oscillator.parameters.contains(name));
    let mut letters = ["a", "b", "h", "u"].into_iter().map(with);
    letters.find(free).unwrap_or_else(|| with("a_"))
}

/// The balance of every harmonic and the amplitude condition, where the force allows it in closed form.
fn equations(
    oscillator: &Oscillator,
    force: &Expr,
    harmonics: &[usize],
    names: &[Symbol],
    motion: &FourierSeries<Polynomial>,
) -> Result<Option<Vec<Expr>>, Refusal> {
    let inertia = |k: usize, name: Symbol| {
        let square = Polynomial::constant(-Rational::from_integer((k * k).into()));
        square
            .product(&Polynomial::symbol(name))
            .times_monomial(&Monomial::power_of(Symbol::new("omega"), 2))
    };
    let mut equations = Vec::new();
    if let Some(coefficients) = polynomial_coefficients(oscillator, force)? {
        // Roughly the number of products of a power of so many harmonics.
        let degree = coefficients.len().saturating_sub(1) as u32;
        if harmonics.len().saturating_pow(degree) > MOST_TERMS {
            return Ok(None);
        }
        let along = horner(&coefficients, motion)?;
        for (&k, &name) in harmonics.iter().zip(names) {
            let coefficient = along.cosine(k);
            let (numerator, denominator) = coefficient.mean();
            let mut equation = numerator.map(|value| value / Rational::from_integer(denominator.clone()));
            equation.accumulate(&inertia(k, name));
            equations.push(Expr::from(&equation));
        }
    } else {
        // A mean and one harmonic: x = a0 + a1 cos theta in closed form.
        let (shift, amplitude) = match (harmonics, names) {
            ([0, 1], [a0, a1]) => (Expr::from(*a0), Expr::from(*a1)),
            ([1], [a1]) => (Expr::zero(), Expr::from(*a1)),
            _ => return Ok(None),
        };
        let moved = force.substitute(oscillator.coordinate, &(Expr::from(oscillator.coordinate) + shift))?;
        for (&k, &name) in harmonics.iter().zip(names) {
            let Some(coefficient) = cosine_coefficient(&moved, oscillator.coordinate, &amplitude, k) else {
                return Ok(None);
            };
            let half = if k == 0 {
                crate::exact::rational::ratio(1, 2)
            } else {
                Rational::one()
            };
            let balance = coefficient * Expr::number(half) + Expr::from(&inertia(k, name));
            equations.push(balance.expand()?);
        }
    }
    let sum = Expr::sum(names.iter().map(|&name| Expr::from(name)));
    equations.push(sum - Expr::symbol("A"));
    let length: usize = equations.iter().map(|equation| equation.terms().len()).sum();
    Ok((length <= MOST_TERMS).then_some(equations))
}

/// A balance solved by numbers.
pub struct Balance {
    /// omega^2.
    pub frequency_squared: f64,
    /// The motion.
    pub motion: FourierSeries<f64>,
}

/// Solves the balance for the motion with `x(0) = amplitude` about zero; `None` where Newton's iteration finds no way there.
pub fn balance(
    force: &dyn Fn(f64) -> f64,
    slope: &dyn Fn(f64) -> f64,
    degree: Option<u32>,
    odd: bool,
    order: u32,
    amplitude: f64,
) -> Option<Balance> {
    let harmonics = harmonics(order, odd);
    let highest = *harmonics.last()?;
    let exact = degree.map(|degree| (degree as usize + 1) * highest / 2 + 2);
    let mut points = exact.unwrap_or(8 * highest + 32);
    let mut solution = continued(force, slope, &harmonics, points, amplitude)?;
    if exact.is_none() {
        /// Points beyond which a force with corners is taken as it is.
        const MOST_POINTS: usize = 1 << 13;
        loop {
            points *= 2;
            let finer = newton(force, slope, &Grid::new(&harmonics, points), amplitude, &solution)?;
            let change = (finer[0] - solution[0]).abs() / finer[0].abs();
            solution = finer;
            if change < 1e-13 || points > MOST_POINTS {
                break;
            }
        }
    }
    let mut cosine = vec![0.0; highest + 1];
    for (&k, value) in harmonics.iter().zip(solution.iter().skip(1)) {
        cosine[k] = *value;
    }
    Some(Balance {
        frequency_squared: solution[0],
        motion: FourierSeries::from_parts(cosine, vec![], Integer::one()),
    })
}

/// Cosines of the harmonics at the points of half a period.
struct Grid {
    harmonics: Vec<usize>,
    /// One row for each point.
    cosines: DMatrix<f64>,
}

impl Grid {
    fn new(harmonics: &[usize], points: usize) -> Self {
        let cosines = DMatrix::from_fn(points, harmonics.len(), |i, j| {
            let theta = std::f64::consts::PI * (i as f64 + 0.5) / points as f64;
            (harmonics[j] as f64 * theta).cos()
        });
        Self {
            harmonics: harmonics.to_vec(),
            cosines,
        }
    }
}

/// Raises the amplitude from where the first harmonic alone is a good start.
fn continued(
    force: &dyn Fn(f64) -> f64,
    slope: &dyn Fn(f64) -> f64,
    harmonics: &[usize],
    points: usize,
    amplitude: f64,
) -> Option<DVector<f64>> {
    const SMALLEST_STEP: f64 = 1e-6;
    let grid = Grid::new(harmonics, points);
    let first = harmonics.iter().position(|&k| k == 1)?;
    let alone = |amplitude: f64| {
        let mut start = DVector::zeros(harmonics.len() + 1);
        start[0] = super::one_term::coefficient_by_quadrature(force, amplitude, 1).0 / amplitude;
        start[first + 1] = amplitude;
        start
    };
    let accepted = |start: &DVector<f64>, part: f64| {
        newton(force, slope, &grid, part * amplitude, start).filter(|found| found[0] > 0.0)
    };
    // Straight away where that leads to the same branch: close to the one-term answer.
    let start = alone(amplitude);
    if let Some(found) = accepted(&start, 1.0).filter(|found| (found[0] / start[0]).ln().abs() < 0.1) {
        return Some(found);
    }
    let (mut part, mut step) = (1.0 / 64.0, 1.0 / 16.0);
    let mut current = accepted(&alone(part * amplitude), part)?;
    while part < 1.0 {
        let next = f64::min(part + step, 1.0);
        let mut start = &current * (next / part);
        start[0] = current[0];
        match accepted(&start, next).filter(|found| (found[0] / current[0]).ln().abs() < 0.5) {
            Some(found) => {
                (current, part) = (found, next);
                step = f64::min(2.0 * step, 0.25);
            }
            None => step *= 0.5,
        }
        if step < SMALLEST_STEP {
            return None;
        }
    }
    Some(current)
}

/// Newton's iteration on `[omega^2, a_k...]`.
fn newton(
    force: &dyn Fn(f64) -> f64,
    slope: &dyn Fn(f64) -> f64,
    grid: &Grid,
    amplitude: f64,
    start: &DVector<f64>,
) -> Option<DVector<f64>> {
    const ITERATIONS: usize = 30;
    let count = grid.harmonics.len();
    let points = grid.cosines.nrows();
    let weight = |k: usize| if k == 0 { 1.0 } else { 2.0 } / points as f64;
    let mut unknowns = start.clone();
    let mut settled = false;
    for _ in 0..ITERATIONS {
        let position = &grid.cosines * unknowns.rows(1, count);
        let forces = position.map(force);
        let slopes = position.map(slope);
        if forces.iter().chain(slopes.iter()).any(|value| !value.is_finite()) {
            return None;
        }
        let mut weighted = grid.cosines.clone();
        for mut column in weighted.column_iter_mut() {
            column.component_mul_assign(&slopes);
        }
        let projected = grid.cosines.transpose() * &forces;
        let products = grid.cosines.transpose() * &weighted;
        let squared = unknowns[0];
        let mut residual = DVector::zeros(count + 1);
        let mut jacobian = DMatrix::zeros(count + 1, count + 1);
        for (row, &k) in grid.harmonics.iter().enumerate() {
            let inertia = (k * k) as f64;
            residual[row] = weight(k) * projected[row] - inertia * squared * unknowns[row + 1];
            jacobian[(row, 0)] = -inertia * unknowns[row + 1];
            for column in 0..count {
                jacobian[(row, column + 1)] = weight(k) * products[(row, column)];
            }
            jacobian[(row, row + 1)] -= inertia * squared;
        }
        residual[count] = unknowns.rows(1, count).sum() - amplitude;
        for column in 0..count {
            jacobian[(count, column + 1)] = 1.0;
        }
        let change = jacobian.lu().solve(&residual)?;
        unknowns -= &change;
        let scale = unknowns.rows(1, count).amax();
        let small = change[0].abs() <= 1e-14 * unknowns[0].abs() && change.rows(1, count).amax() <= 1e-14 * scale;
        if small || (settled && change[0].abs() <= 1e-11 * unknowns[0].abs()) {
            return unknowns.iter().all(|value| value.is_finite()).then_some(unknowns);
        }
        // Rounding may keep the last digits moving: one step more after they are small is enough.
        settled = change[0].abs() <= 1e-11 * unknowns[0].abs() && change.rows(1, count).amax() <= 1e-11 * scale;
    }
    None
}

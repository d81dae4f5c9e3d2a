//! The radius of convergence of the series behind a formula, estimated from its coefficients.
//!
//! References: C. Domb, M. F. Sykes, Proc. R. Soc. Lond. A 240 (1957) 214-228 (ratios of
//! coefficients); D. L. Hunter, G. A. Baker, Phys. Rev. B 19 (1979) 3808-3821 (recurrences of
//! coefficients: integral approximants).
//!
//! ```text
//! one singularity at s_0:     c_k/c_(k-1) -> (1/s_0)(1 + b/k + ...)
//! a pair at R e^(+-i phi):    c_k = (a_0 + a_1/k + a_2/k^2) c_(k-1) + (b_0 + b_1/k + b_2/k^2) c_(k-2),
//!                             a_0 = 2 cos(phi)/R,  b_0 = -1/R^2
//! ```
//!
//! An estimate is given only where two windows of coefficients, the last ones and those before,
//! agree on it. If a solution has enough exact coefficients, the radius follows [from
//! these](converges), with as many digits as they support.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use num_integer::Integer as _;
use num_traits::{One, Zero};

use super::amplitude_series::amplitude_series;
use super::validity::Range;
use crate::decimal::{decimal, significant};
use crate::exact::rational::to_f64;
use crate::exact::{Doubles, Monomial, Polynomial, Rational};
use crate::expr::Expr;
use crate::method::power_series::PowerSeries;
use crate::method::secular::{AmplitudeKind, Detuning, ForceTerm, Scheme, expand};
use crate::oscillator::{Oscillator, SmallParameter};
use crate::series::recurrence::numeric_taylor;
use crate::series::{FourierSeries, singularity};
use crate::solution::{AmplitudeConvention, Convergence, Counts, Note, Solution};
use crate::symbol::Symbol;

/// Number of coefficients from which the radius of convergence is estimated.
const SERIES_TERMS: usize = 24;

/// The estimate of a series' nearest singularity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Singularity {
    /// Its distance from zero: the radius of convergence.
    pub radius: f64,
    /// Its angle in the complex plane: 0 on the positive axis, pi on the negative one.
    pub angle: f64,
}

/// Number of coefficients to which a law of ratios is fitted.
const WINDOW: usize = 8;

/// Relative agreement of the radii by two windows of coefficients that is required.
const AGREEMENT: f64 = 0.01;

/// The nearest singularity of the series of omega^2 in a solution, by its [own exact
/// coefficients](crate::series::singularity); `None` if it has too few of them, symbols that do not
/// enter in step with the order, or coefficients that show no law.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::{Options, Oscillator, exact::ratio, solve, verify::converges};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options { order: Some(40), ..Options::default() })?;
/// let found = converges(&solution).ok_or("a regular series")?;
/// assert_eq!((found.variable_in_words().as_str(), &found.nearest.place[0].value), ("eps*A^2", &ratio(-1, 1)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn converges(solution: &Solution) -> Option<Convergence> {
    let (variable, coefficients) = exact_coefficients(solution)?;
    Some(Convergence {
        variable,
        highest: coefficients.len() - 1,
        nearest: singularity::nearest(&coefficients)?,
    })
}

/// The note that the series of omega^2 in a solution has no singularity, by its own exact
/// coefficients: it ends, or they fall faster than any power. `None` if neither is the case.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::{Options, Oscillator, solve, verify::{converges, converges_everywhere}};
///
/// // omega^2 = 1 - (1 - exp(-A))^2
/// let morse = Oscillator::parse("x'' + exp(-x) - exp(-2*x) = 0")?;
/// let solution = solve(&morse, &Options { order: Some(24), ..Options::default() })?;
/// assert!(converges(&solution).is_none() && converges_everywhere(&solution).is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn converges_everywhere(solution: &Solution) -> Option<Note> {
    let (variable, coefficients) = exact_coefficients(solution)?;
    let last = singularity::last_power(&coefficients);
    (last.is_some() || singularity::is_entire(&coefficients)).then(|| Note::ConvergesEverywhere {
        last: last.map(|last| variable.power(i32::try_from(last).unwrap_or(1))),
        variable,
        highest: coefficients.len() - 1,
    })
}

/// The series of omega^2 in the highest power of its variable that all of its terms have, with
/// exact coefficients.
fn exact_coefficients(solution: &Solution) -> Option<(Monomial, Vec<Rational>)> {
    // Rounded coefficients are no more accurate than those that are computed below.
    if solution.numerical {
        return None;
    }
    let (mut variable, mut coefficients) =
        PowerSeries::from_solution(solution, true).in_one_variable()?;
    if solution.method.counts() == Counts::Powers {
        // Powers up to the order of the answer that do not occur in the law have the coefficient
        // zero.
        let count = solution.order as usize
            / usize::try_from(PowerSeries::from_solution(solution, true).step).ok()?;
        coefficients.resize((count + 1).max(coefficients.len()), Rational::zero());
    }
    let powers = coefficients.iter().enumerate().filter(|(_, value)| !value.is_zero());
    let step = powers.fold(0, |common: usize, (power, _)| common.gcd(&power));
    if step > 1 {
        variable = variable.power(i32::try_from(step).ok()?);
        coefficients = coefficients.into_iter().step_by(step).collect();
    }
    Some((variable, coefficients))
}

/// The radius of convergence of the series of `solution` in its small parameter, in words; `None`
/// if its coefficients show no law.
pub(super) fn convergence(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<Range> {
    if let Some(known) = &solution.convergence {
        return at_numbers(solution, known, numbers);
    }
    let small = solution.small_parameter;
    let value = numbers.get(&small).copied()?;
    let series = match small == solution.amplitude.symbol() {
        true => in_the_amplitude(oscillator, solution, numbers, value)?,
        false => in_a_parameter(oscillator, solution, numbers, small)?,
    };
    let even = series.coefficients.iter().skip(1).step_by(2).all(|c| *c == 0.0);
    let coefficients: Vec<f64> =
        series.coefficients.iter().step_by(if even { 2 } else { 1 }).copied().collect();
    let found = nearest_singularity(&coefficients)?;
    let (variable, radius, size) = match even {
        true => (
            format!("{small}^2"),
            series.unit * found.radius.sqrt(),
            series.unit.powi(2) * found.radius,
        ),
        false => (small.to_string(), series.unit * found.radius, series.unit * found.radius),
    };
    let size = significant(size, 3);
    let place = match found.angle {
        angle if angle < 1e-9 => format!("{variable} = {size}"),
        angle if angle > std::f64::consts::PI - 1e-9 => format!("{variable} = -{size}"),
        angle => format!("{variable} = {size} e^(+-{}i)", significant(angle, 3)),
    };
    Some(Range {
        text: format!(
            "the series converges for |{small}| < about {}: from {} coefficients the nearest singularity is at {place}",
            significant(radius, 3),
            coefficients.len() - 1,
        ),
        outside: value.abs() >= radius,
    })
}

/// Whether the numbers lie within the radius that is known.
fn at_numbers(
    solution: &Solution,
    known: &Convergence,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<Range> {
    let variable = Polynomial::term(known.variable.clone(), Rational::one());
    let value = solution.evaluate(&variable, &|name| numbers.get(&name).copied()).ok()?;
    let radius = to_f64(&known.nearest.radius.value);
    let text = match known.in_symbol() {
        Some((symbol, size)) => {
            format!("the series converges for |{symbol}| < {}", decimal(to_f64(&size.value)))
        }
        None => format!(
            "the series converges for |{}| < {}",
            known.variable_in_words(),
            decimal(radius)
        ),
    };
    Some(Range { text, outside: value.abs() >= radius })
}

/// omega^2 in powers of the small parameter over a unit, up to a factor.
struct FrequencySeries {
    coefficients: Vec<f64>,
    unit: f64,
}

/// The unit of `x` in which the largest Taylor coefficient of the force is of the size of the
/// linear one, given the coefficients in another unit.
fn unit_of_growth(force: &[f64]) -> f64 {
    let linear = force[1];
    let rate = |(k, value): (usize, &f64)| (value / linear).abs().powf(1.0 / (k as f64 - 1.0));
    force.iter().enumerate().skip(2).map(rate).fold(0.0, f64::max)
}

/// The series in the amplitude of a force of the position alone.
fn in_the_amplitude(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    amplitude: f64,
) -> Option<FrequencySeries> {
    let (highest, few) = (2 * SERIES_TERMS + 1, 9);
    if oscillator.force.contains(oscillator.velocity()) {
        return None;
    }
    let force = with_numbers(oscillator, numbers, solution.amplitude.symbol())?.force;
    let equilibrium = solution.equilibrium.evaluate(numbers).ok()?;
    let taylor = |unit: f64, degree: usize| {
        numeric_taylor(&force, oscillator.coordinate, equilibrium, unit, degree)
    };
    // The first unit is the amplitude, the second that of the nonlinearity, in which powers neither
    // underflow nor overflow.
    let mut unit = amplitude.abs();
    for degree in [few, highest] {
        let rate = unit_of_growth(&taylor(unit, degree)?);
        if !rate.is_normal() {
            return None;
        }
        unit /= rate;
    }
    let mut coefficients = taylor(unit, highest)?;
    let linear = coefficients[1];
    if linear <= 0.0 || !linear.is_normal() {
        return None;
    }
    coefficients.iter_mut().for_each(|c| *c /= linear);
    // Where all low powers are rounding, as of `asin(sin(x))`, so are the high ones that have grown from it.
    let mut low = coefficients[2..=few].iter().filter(|c| **c != 0.0).peekable();
    if low.peek().is_some() && low.all(|c| c.abs() < 1e-13) {
        return None;
    }
    // About an equilibrium that is rounded, an odd force is not quite odd.
    let even = || (2..highest + 1).step_by(2);
    if even().all(|k| coefficients[k].abs() < 1e-14) {
        even().for_each(|k| coefficients[k] = 0.0);
    }
    (coefficients[1], coefficients[0]) = (1.0, 0.0);
    Some(FrequencySeries { coefficients: amplitude_series(&coefficients)?, unit })
}

/// The series in a parameter at the given amplitude, by elimination of secular terms in
/// floating-point numbers.
fn in_a_parameter(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    small: Symbol,
) -> Option<FrequencySeries> {
    let cycle = solution.limit_cycle.as_ref();
    // The frequency of most limit cycles has even powers alone.
    let highest = if cycle.is_some() { 2 * SERIES_TERMS } else { SERIES_TERMS };
    let amplitude = match cycle {
        // The series of a limit cycle begins with the leading amplitude.
        Some(cycle) => {
            let value_of = |symbol: Symbol| numbers.get(&symbol).copied();
            solution.evaluate(&solution.leading(&cycle.amplitude), &value_of).ok()?
        }
        None => *numbers.get(&solution.amplitude.symbol())?,
    };
    let (terms, unit) = in_numbers(oscillator, numbers, (small, highest), amplitude)?;
    let scheme = Scheme {
        normalisation: AmplitudeConvention::Initial,
        amplitude: match cycle {
            Some(_) => AmplitudeKind::Determined,
            None => AmplitudeKind::Free,
        },
        detuning: Detuning::Acceleration,
    };
    let expansion = expand(&Doubles, &terms, highest, &scheme).ok()?;
    let mut coefficients: Vec<f64> =
        expansion.frequency_squared.iter().map(|constant| constant.mean().0).collect();
    if cycle.is_some() {
        forget_odd_noise(&mut coefficients);
    }
    Some(FrequencySeries { coefficients, unit })
}

/// Removes odd powers that rounding leaves in the series of a limit cycle.
fn forget_odd_noise(coefficients: &mut [f64]) {
    let mut odd = (1..coefficients.len()).step_by(2);
    if odd.all(|k| coefficients[k].abs() < 1e-9 * coefficients[k - 1].abs()) {
        let odd = coefficients.iter_mut().skip(1).step_by(2);
        odd.for_each(|value| *value = 0.0);
    }
}

/// The terms of the force at an amplitude, in units of the linear frequency and of a value of the
/// small parameter that makes the largest one; and that value. `None` if the force is not a sum of
/// a few powers.
fn in_numbers(
    oscillator: &Oscillator,
    numbers: &BTreeMap<Symbol, f64>,
    (small, highest): (Symbol, usize),
    amplitude: f64,
) -> Option<(Vec<ForceTerm<Doubles>>, f64)> {
    /// Largest number of terms: with more, the products would cost more than the rest of the
    /// answer.
    const MOST_TERMS: usize = 8;
    const HIGHEST_POWER: u32 = 9;
    let numerical = with_numbers(oscillator, numbers, small)?;
    let centred = crate::equilibrium::centred(&numerical, None).ok()?;
    let expanded = centred.oscillator.expand(SmallParameter::Parameter(small), highest as u32);
    let force = expanded.ok()?;
    if force.terms.len() > MOST_TERMS
        || force.terms.iter().any(|term| term.position + term.velocity > HIGHEST_POWER)
    {
        return None;
    }
    let number = |polynomial: &crate::exact::Polynomial| {
        let value = |symbol| {
            let meaning =
                force.definitions.iter().find(|definition| definition.symbol == symbol)?;
            meaning.meaning.evaluate(numbers).ok()
        };
        let pi = Symbol::new("pi");
        let value = |symbol| value(symbol).or((symbol == pi).then_some(std::f64::consts::PI));
        polynomial.evaluate(value).ok()
    };
    let linear = number(&force.linear).filter(|linear| *linear > 0.0)?;
    // C_j = c_j A^(p+q-1) omega0^(q-2), and the unit of the parameter in which the largest is one.
    let scaled = |term: &crate::oscillator::Term| {
        let power = i32::try_from(term.position + term.velocity).ok()? - 1;
        let value = number(&term.coefficient)? / linear * amplitude.powi(power);
        Some(value * linear.sqrt().powi(i32::try_from(term.velocity).ok()?))
    };
    let values: Vec<f64> = force.terms.iter().map(scaled).collect::<Option<_>>()?;
    let sizes = values.iter().zip(&force.terms);
    let largest =
        sizes.map(|(value, term)| value.abs().powf(1.0 / term.order as f64)).fold(0.0, f64::max);
    if !largest.is_normal() {
        return None;
    }
    let terms = values
        .iter()
        .zip(&force.terms)
        .map(|(value, term)| ForceTerm {
            order: term.order,
            position: term.position,
            velocity: term.velocity,
            coefficient: FourierSeries::constant(Doubles, value / largest.powi(term.order as i32)),
        })
        .collect();
    Some((terms, 1.0 / largest))
}

/// The equation with exact numbers for all parameters but one.
fn with_numbers(
    oscillator: &Oscillator,
    numbers: &BTreeMap<Symbol, f64>,
    but: Symbol,
) -> Option<Oscillator> {
    let names = oscillator.parameters.iter().filter(|&&name| name != but);
    let exact = |name: &Symbol| {
        let value = crate::decimal::rounded(*numbers.get(name)?);
        Some((*name, Expr::number(value)))
    };
    let values = names.map(exact).collect::<Option<_>>()?;
    oscillator.with_values(&values).ok()
}

/// The nearest singularity of a power series, from its coefficients; `None` if they show no regular
/// pattern.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// let geometric: Vec<f64> = (0..30).map(|n| 0.5_f64.powi(n)).collect(); // 1/(1 - x/2)
/// let pole = lindstedt::verify::nearest_singularity(&geometric).expect("a pole");
/// assert!((pole.radius - 2.0).abs() < 1e-6 && pole.angle.abs() < 1e-6);
/// ```
pub fn nearest_singularity(coefficients: &[f64]) -> Option<Singularity> {
    let earlier = coefficients.len().checked_sub(3)?;
    let (last, before) = (estimate(coefficients)?, estimate(&coefficients[..earlier])?);
    let agree = (last.radius / before.radius - 1.0).abs() < AGREEMENT
        && (last.angle - before.angle).abs() < 0.05;
    agree.then_some(last)
}

fn estimate(coefficients: &[f64]) -> Option<Singularity> {
    if coefficients.len() < 2 * WINDOW + 4
        || coefficients.iter().rev().take(WINDOW + 3).any(|c| *c == 0.0 || !c.is_finite())
    {
        return None;
    }
    let ratio = |k: usize| coefficients[k] / coefficients[k - 1];
    let last = coefficients.len() - 1;
    let window: Vec<usize> = (last + 1 - WINDOW..=last).collect();
    let signs: f64 = window.iter().map(|&k| ratio(k).signum()).sum();
    if signs.abs() == WINDOW as f64 {
        let inverse = extrapolated(&window, &ratio)?;
        // The limit must be near the ratios themselves, or they follow no such law.
        if (inverse / ratio(last)).ln().abs() < 0.5 && inverse * signs > 0.0 {
            let angle = if inverse > 0.0 { 0.0 } else { std::f64::consts::PI };
            return Some(Singularity { radius: 1.0 / inverse.abs(), angle });
        }
    }
    pair(coefficients)
}

/// A pair of complex singularities: the recurrence in the head of this file, by least squares.
fn pair(coefficients: &[f64]) -> Option<Singularity> {
    const ROWS: usize = 16;
    const UNKNOWNS: usize = 6;
    let first = coefficients.len().checked_sub(ROWS).filter(|first| *first >= 2)?;
    let mut matrix = DMatrix::zeros(ROWS, UNKNOWNS);
    let mut right = DVector::zeros(ROWS);
    for row in 0..ROWS {
        let k = first + row;
        let [own, one, two] = [0, 1, 2].map(|back| coefficients[k - back]);
        // Rows are normalised, so that they have equal weight however fast the coefficients grow.
        let size = own.abs().max(one.abs()).max(two.abs());
        let inverse = 1.0 / k as f64;
        let columns = [
            one,
            one * inverse,
            one * inverse * inverse,
            two,
            two * inverse,
            two * inverse * inverse,
        ];
        for (column, value) in columns.into_iter().enumerate() {
            matrix[(row, column)] = value / size;
        }
        right[row] = own / size;
    }
    if matrix.iter().chain(right.iter()).any(|value| !value.is_finite()) {
        return None;
    }
    let solved = matrix.clone().svd(true, true).solve(&right, 1e-14).ok()?;
    // The residual of the fit says whether the coefficients follow the law at all.
    let left_over = (&matrix * &solved - &right).norm() / right.norm();
    let (alpha, beta) = (solved[0], solved[3]);
    let cosine = 0.5 * alpha / (-beta).sqrt();
    (left_over < 1e-3 && beta < 0.0 && cosine.abs() <= 1.0)
        .then(|| Singularity { radius: 1.0 / (-beta).sqrt(), angle: cosine.acos() })
}

/// The limit of a sequence `limit (1 + b/k + c/k^2)` by least squares over a window.
fn extrapolated(window: &[usize], of: &dyn Fn(usize) -> f64) -> Option<f64> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for &k in window {
        let inverse = 1.0 / k as f64;
        let row = Vector3::new(1.0, inverse, inverse * inverse);
        normal += row * row.transpose();
        right += row * of(k);
    }
    let fitted = normal.lu().solve(&right)?;
    fitted[0].is_finite().then_some(fitted[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_singularities() {
        // (1 - s/s0)^(1/2): c_k = c_(k-1) (k - 3/2)/(k s0).
        for s0 in [2.0, -0.3] {
            let mut series = vec![1.0];
            for k in 1..=24 {
                series.push(series[k - 1] * (k as f64 - 1.5) / (k as f64 * s0));
            }
            let found = nearest_singularity(&series).unwrap();
            assert!((found.radius / f64::abs(s0) - 1.0).abs() < 1e-4, "{found:?}");
        }
        // 1/(1 - 2 s cos(phi)/R + (s/R)^2): c_k = sin((k+1) phi)/(R^k sin phi), a pair of poles at
        // R e^(+-i phi).
        let (radius, phi) = (1.5_f64, 1.0_f64);
        let series: Vec<f64> = (0..=24)
            .map(|k| (f64::from(k + 1) * phi).sin() / (radius.powi(k) * phi.sin()))
            .collect();
        let found = nearest_singularity(&series).unwrap();
        assert!(
            (found.radius - radius).abs() < 1e-6 && (found.angle - phi).abs() < 1e-6,
            "{found:?}"
        );
    }

    #[test]
    fn the_lattice_of_toda_converges_up_to_2_398() {
        let force: Vec<f64> = (0..=49)
            .scan(1.0, |c, k| {
                *c /= f64::from(k.max(1));
                Some(if k == 0 { 0.0 } else { *c })
            })
            .collect();
        let found = nearest_singularity(&amplitude_series(&force).unwrap()).unwrap();
        assert!((found.radius - 2.398).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn no_pattern_gives_no_number() {
        // exp(s) has no singularity; coefficients that end or jump about have no law.
        let factorials: Vec<f64> = (0..=24)
            .scan(1.0, |c, k| {
                *c /= f64::from(k.max(1));
                Some(*c)
            })
            .collect();
        assert_eq!(nearest_singularity(&factorials), None);
        let noise: Vec<f64> = (0..=24).map(|k| f64::from((k * k * 7919) % 31) - 15.5).collect();
        assert_eq!(nearest_singularity(&noise), None);
        assert_eq!(pair(&noise), None);
        // Three equal waves obey no recurrence of two terms.
        let waves: Vec<f64> = (0..=24)
            .map(|k| [0.6, 1.3, 2.2].map(|phi| (f64::from(k) * phi + phi).sin()).iter().sum())
            .collect();
        assert_eq!(pair(&waves), None);
        // Ratios that change near the end leave it open where the singularity is.
        for (kink, ratio) in [(22, 1.1), (21, 0.9), (20, 1.05)] {
            let bent: Vec<f64> = (0..=24)
                .scan(1.0, |c, k| {
                    *c *= if k < kink { 1.0 } else { ratio };
                    Some(*c)
                })
                .collect();
            assert_eq!(nearest_singularity(&bent), None, "{kink}");
        }
    }
}

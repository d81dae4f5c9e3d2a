//! Pade approximants of omega^2: quotients of polynomials that agree with the exact series.
//!
//! Reference: G. A. Baker, P. Graves-Morris, *Pade Approximants*, 2nd ed., Cambridge 1996,
//! section 1.1.
//!
//! ```text
//! omega^2 = c_0 + c_1 s + c_2 s^2 + ...,   s = A^2, or the small parameter
//! [L/M] = (p_0 + ... + p_L s^L)/(q_0 + ... + q_M s^M) = omega^2 + O(s^(L+M+1))
//! sum_j q_j c_(L+k-j) = 0, k = 1..M    (q_0 = 1)      ,       p_i = sum_j q_j c_(i-j)
//! ```
//!
//! `L = M + 1` suits a hardening spring, whose omega^2 grows like s; `L = M` one that saturates.
//! The coefficients are those of [Lindstedt and Poincare](super::lindstedt_poincare), exact. High
//! degrees are worked out [modulo many primes](crate::series::hermite_pade::by_primes), from the
//! frequency alone.
//!
//! Cost: the exact series to order `L + M`, then `O((L + M)^2)` products of rational numbers, or of
//! residues for each of as many primes as the numbers have digits.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::{Degrees, Method}};
//! let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
//! let options = Options { method: Some(Method::Pade), degrees: Some(Degrees::Quotient(1, 1)), ..Options::default() };
//! assert_eq!(solve(&pendulum, &options)?.law.closed_form().unwrap().to_string(), "omega^2 = (192 - 17*A^2)/(192 + 7*A^2)");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::collections::BTreeMap;

use num_traits::{One, Zero};

use super::power_series::{CONSTANT, PowerSeries, Resummed, STOPPED, TOO_LONG, has_values, scaled};
use super::{Options, Reason, Refusal};
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::exact::big_float::BigFloat;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::to_f64;
use crate::exact::{Integer, Polynomial, Rational};
use crate::expr::Expr;
use crate::numeric::ode::polynomial::real_zeros;
use crate::oscillator::Oscillator;
use crate::series::hermite_pade::by_primes::exact;
use crate::solution::{Degrees, Method, Note, Solution, note::Poles};
use crate::symbol::{Symbol, fresh_stem};

const METHOD: Method = Method::Pade;

/// The largest degree, of numerator and denominator.
const LARGEST_DEGREE: u32 = 60;

/// Degree of the denominator beyond which elimination modulo primes is faster than with long
/// fractions.
const LARGEST_BY_FRACTIONS: usize = 12;

/// The largest degree of a denominator with symbols that cannot be scaled away: its cofactors are
/// sums of `2^degree` products of polynomials.
const LARGEST_WITH_SYMBOLS: usize = 9;

/// The approximant of the degrees in the options, `[2/1]` by default.
///
/// # Errors
/// As for the method of Lindstedt and Poincare; degrees without an approximant.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    let degrees = options.degrees.unwrap_or(Degrees::Quotient(2, 1));
    let refused = |reason| Refusal::from(Reason::Approximant { method: METHOD, degrees, reason });
    let Degrees::Quotient(numerator_degree, denominator_degree) = degrees else {
        return Err(refused("it has two, those of numerator and denominator"));
    };
    if numerator_degree > LARGEST_DEGREE || denominator_degree > LARGEST_DEGREE {
        return Err(refused("degrees go up to [60/60]"));
    }
    let order = numerator_degree + denominator_degree;
    let resummed =
        Resummed::new(oscillator, options, (METHOD, order))?.ok_or_else(|| refused(STOPPED))?;
    let series = &resummed.series;
    let quotient = quotient(series, (numerator_degree, denominator_degree)).map_err(refused)?;
    let below = series.with_powers(&quotient.below);
    let value =
        Expr::divide(&Expr::from(&series.with_powers(&quotient.above)), &Expr::from(&below))?;
    if !has_values(&value) {
        return Err(refused(TOO_LONG));
    }
    let notes = vec![resummed.agreement(degrees), Note::Poles(poles(&below)), Note::MotionOfSeries];
    let letters = ["p", "q"].map(|letter| fresh_stem(letter, &resummed.names()));
    let derivation = match resummed.long {
        // Equations by the dozen, with coefficients of thousands of digits.
        true => vec![DerivationLine::words(format!(
            "the {denominator_degree} linear equations for the denominator are solved modulo many primes, and put together"
        ))],
        false => linear_system(series, &quotient, &letters),
    };
    Ok(resummed.answer(degrees, (value, vec![]), (notes, derivation)))
}

/// Numerator and denominator of these degrees whose quotient agrees with a series in the square of its
/// amplitude.
///
/// # Errors
/// The reason why there is none, in words.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::expr::{Expr, parse_expression};
/// use lindstedt::{Symbol, method::approximant};
///
/// let series = parse_expression("1 - a^2/8 + 7*a^4/1536")?.to_polynomial(&mut |_| None)?;
/// let [above, below] = approximant(series.expect("a polynomial"), Symbol::new("a"), (1, 1))?;
/// assert_eq!(Expr::from(&above).to_string(), "1 - 17*a^2/192");
/// assert_eq!(Expr::from(&below).to_string(), "1 + 7*a^2/192");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn approximant(
    series: Polynomial,
    amplitude: Symbol,
    degrees: (u32, u32),
) -> Result<[Polynomial; 2], &'static str> {
    let series = PowerSeries { law: series, small: amplitude, step: 2 };
    let Quotient { above, below } = quotient(&series, degrees)?;
    let parts = [above, below].map(|part| series.with_powers(&part));
    let [above, below] = parts.each_ref().map(Expr::from);
    let value = Expr::divide(&above, &below).map_err(|_| SINGULAR)?;
    if has_values(&value) { Ok(parts) } else { Err(TOO_LONG) }
}

/// The coefficients of numerator and denominator.
struct Quotient {
    above: Vec<Polynomial>,
    below: Vec<Polynomial>,
}

/// The quotient of these degrees that agrees with a series, or the reason why there is none.
fn quotient(
    series: &PowerSeries,
    (numerator_degree, denominator_degree): (u32, u32),
) -> Result<Quotient, &'static str> {
    let (l, m) = (i64::from(numerator_degree), denominator_degree as usize);
    let coefficients: Vec<Polynomial> =
        (0..=l + m as i64).map(|power| series.coefficient(power)).collect();
    if m > LARGEST_BY_FRACTIONS
        && let Some((unit, numbers)) = scaled(&coefficients)
    {
        return by_primes(&coefficients[0], &unit, numbers, (numerator_degree as usize, m));
    }
    let below = denominator(&coefficients, l, m)?;
    let entry = |i: i64| {
        let mut sum = Polynomial::zero();
        for (j, q) in below.iter().enumerate() {
            sum.accumulate(&q.product(&series.coefficient(i - j as i64)));
        }
        sum
    };
    Ok(Quotient { above: (0..=l).map(entry).collect(), below })
}

/// The quotient of a series `c_k = c_0 unit^k n_k` in numbers, modulo many primes.
fn by_primes(
    first: &Polynomial,
    unit: &Monomial,
    numbers: Vec<Rational>,
    (above, below): (usize, usize),
) -> Result<Quotient, &'static str> {
    if numbers.iter().skip(1).all(Zero::is_zero) {
        return Err(CONSTANT);
    }
    let mut minus_one = vec![Rational::zero(); numbers.len()];
    minus_one[0] = -Rational::one();
    let lists = exact(&[(numbers, below), (minus_one, above)]).ok_or(SINGULAR)?;
    let [below, above] = lists.as_slice() else {
        return Err(SINGULAR);
    };
    let (symbols, _) = first.single_term().ok_or(SINGULAR)?;
    let polynomials = |numbers: &[Integer], start: &Monomial| -> Vec<Polynomial> {
        let term = |(power, number): (i32, &Integer)| {
            let value = Rational::new(number.clone(), below[0].clone());
            Polynomial::term(start.product(&unit.power(power)), value)
        };
        (0..).zip(numbers).map(term).collect()
    };
    Ok(Quotient { above: polynomials(above, symbols), below: polynomials(below, &Monomial::one()) })
}

/// The reason why there is no quotient.
const SINGULAR: &str = "the equations for its denominator are singular";

/// The equations for the denominator and then for the numerator, with the coefficients of this
/// series in them.
fn linear_system(
    series: &PowerSeries,
    Quotient { above, below }: &Quotient,
    [p, q]: &[String; 2],
) -> Vec<DerivationLine> {
    let (l, m) = (above.len() as i64 - 1, below.len() - 1);
    let name = |letter: &str, index: usize| Symbol::new(&format!("{letter}{index}"));
    let unknown = |j: usize| match j {
        0 => Polynomial::constant(Rational::one()),
        _ => Polynomial::symbol(name(q, j)),
    };
    let sum = |highest: i64, most: usize| {
        let mut sum = Polynomial::zero();
        for j in 0..=most {
            sum.accumulate(&unknown(j).product(&series.coefficient(highest - j as i64)));
        }
        sum
    };
    let value = |polynomial: &Polynomial| {
        let first = below.first().map_or_else(Expr::one, Expr::from);
        let polynomial = Expr::from(polynomial);
        Expr::divide(&polynomial, &first).unwrap_or(polynomial)
    };
    let squared = Expr::symbol("omega").integer_power(2).unwrap_or_else(|_| Expr::zero());
    let numerator: Vec<Polynomial> =
        (0..above.len()).map(|i| Polynomial::symbol(name(p, i))).collect();
    let denominator: Vec<Polynomial> = (0..=m).map(unknown).collect();
    let [numerator, denominator] =
        [numerator, denominator].map(|names| Expr::from(&series.with_powers(&names)));
    let mut lines = vec![
        DerivationLine::equation(squared.clone(), &series.law).because("the exact series begins"),
    ];
    if let Ok(quotient) = Expr::divide(&numerator, &denominator) {
        lines.push(DerivationLine::equation(squared, quotient).because("agrees with"));
    }
    for k in 1..=m {
        let words = match k {
            1 => "multiplied out, the powers beyond the numerator vanish",
            _ => "",
        };
        lines.push(DerivationLine::equation(&sum(l + k as i64, m), Expr::zero()).because(words));
    }
    for (j, coefficient) in below.iter().enumerate().skip(1) {
        let words = if j == 1 { "the denominator" } else { "" };
        lines.push(DerivationLine::equation(name(q, j), value(coefficient)).because(words));
    }
    for (i, coefficient) in above.iter().enumerate() {
        let words = if i == 0 { "the numerator" } else { "" };
        let (combination, value) = (Expr::from(&sum(i as i64, i.min(m))), value(coefficient));
        let mut equal: Vec<DerivationFormula> = vec![name(p, i).into(), combination.clone().into()];
        if combination != value {
            equal.push(value.into());
        }
        lines.push(DerivationLine::equal(equal).because(words));
    }
    lines
}

/// `q_0, ..., q_m`, the first of them one where it is a single term; or the reason why there are
/// none.
fn denominator(series: &[Polynomial], l: i64, m: usize) -> Result<Vec<Polynomial>, &'static str> {
    if m > 0 && series.iter().skip(1).all(Polynomial::is_zero) {
        return Err(CONSTANT);
    }
    if let Some((unit, numbers)) = scaled(series) {
        let zero = Rational::zero();
        let number = |power: i64| usize::try_from(power).map_or(&zero, |power| &numbers[power]);
        let row = |k: i64| (1..=m as i64).chain([0]).map(|j| number(l + k - j).clone()).collect();
        let solved = solve_linear((1..=m as i64).map(row).collect()).ok_or(SINGULAR)?;
        let one = std::iter::once(Rational::one());
        let values = one.chain(solved.into_iter().map(|value| -value));
        let term = |(j, value)| Polynomial::term(unit.power(j), value);
        return Ok((0..).zip(values).map(term).collect());
    }
    if m > LARGEST_WITH_SYMBOLS {
        return Err(
            "with these symbols the denominator's degree is at most 9; give numbers for them",
        );
    }
    let coefficient = |power: i64| {
        let power = usize::try_from(power).ok();
        power.map_or_else(Polynomial::zero, |power| series[power].clone())
    };
    let rows: Vec<Vec<Polynomial>> =
        (1..=m as i64).map(|k| (0..=m as i64).map(|j| coefficient(l + k - j)).collect()).collect();
    let mut below = cofactors(&rows);
    let first = below.first().filter(|first| !first.is_zero()).cloned().ok_or(SINGULAR)?;
    normalise(&mut below, &first);
    Ok(below)
}

/// Gauss's elimination, exact: rows of coefficients with the right side last. `None` if the rows
/// depend on each other.
fn solve_linear(mut rows: Vec<Vec<Rational>>) -> Option<Vec<Rational>> {
    for column in 0..rows.len() {
        let pivot = (column..rows.len()).find(|&row| !rows[row][column].is_zero())?;
        rows.swap(column, pivot);
        let inverse = rows[column][column].recip();
        for value in &mut rows[column][column..] {
            *value *= &inverse;
        }
        let pivot = rows[column].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(row, _)| *row != column) {
            let factor = row[column].clone();
            if factor.is_zero() {
                continue;
            }
            for (value, above) in row.iter_mut().zip(&pivot).skip(column) {
                *value -= &factor * above;
            }
        }
    }
    rows.iter().map(|row| row.last().cloned()).collect()
}

/// `(-1)^j` times the determinant of the rows without column `j`, for every `j`: row by row, the
/// minors of all sets of columns by Laplace's expansion.
fn cofactors(rows: &[Vec<Polynomial>]) -> Vec<Polynomial> {
    let mut minors: BTreeMap<u32, Polynomial> =
        BTreeMap::from([(0, Polynomial::constant(Rational::one()))]);
    for row in rows {
        let mut next: BTreeMap<u32, Polynomial> = BTreeMap::new();
        for (columns, minor) in &minors {
            for (column, entry) in row.iter().enumerate() {
                if columns & (1 << column) != 0 || entry.is_zero() {
                    continue;
                }
                let mut term = minor.product(entry);
                if (columns >> column).count_ones() % 2 == 1 {
                    term.negate();
                }
                next.entry(columns | (1 << column))
                    .or_insert_with(Polynomial::zero)
                    .accumulate(&term);
            }
        }
        minors = next;
    }
    let all = (1_u32 << (rows.len() + 1)) - 1;
    let mut cofactor = |j: usize| {
        let mut minor = minors.remove(&(all & !(1 << j))).unwrap_or_else(Polynomial::zero);
        if j % 2 == 1 {
            minor.negate();
        }
        minor
    };
    (0..=rows.len()).map(&mut cofactor).collect()
}

/// Divides by the first coefficient where that is a single term.
fn normalise(coefficients: &mut [Polynomial], first: &Polynomial) {
    let Some((monomial, number)) = first.single_term() else {
        return;
    };
    let (inverse, number) = (monomial.power(-1), number.recip());
    for coefficient in coefficients {
        *coefficient = coefficient.times_monomial(&inverse).map(|value| value * &number);
    }
}

/// The real zeros of the denominator, where it depends on one combination of symbols alone.
fn poles(below: &Polynomial) -> Poles {
    let Some((unit, exact)) = in_one_variable(below) else {
        return Poles::Unknown;
    };
    let coefficients: Vec<f64> = exact.iter().map(to_f64).collect();
    let mut places: Vec<f64> = real_roots(&coefficients);
    if exact.len() > LARGEST_BY_FRACTIONS + 1 {
        // Roots of such a high degree in doubles are kept only where the exact polynomial changes
        // its sign.
        let floats: Vec<BigFloat> =
            exact.iter().map(|value| BigFloat::of_fraction(value, BITS)).collect();
        places.retain(|place| changes_sign(&floats, *place));
    }
    places.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let name = Expr::from(&Polynomial::term(unit, Rational::one()));
    Poles::At { name, places }
}

/// Number of bits that suffice for the sign of a long polynomial.
const BITS: usize = 1024;

/// Whether a polynomial changes its sign close to `place`.
fn changes_sign(polynomial: &[BigFloat], place: f64) -> bool {
    const BESIDE: f64 = 1e-6;
    let zero = BigFloat::zero(BITS);
    let value = |place: f64| {
        let place = BigFloat::of_f64(place, BITS);
        let value =
            polynomial.iter().rev().fold(zero.clone(), |sum, number| &(&sum * &place) + number);
        value > zero
    };
    value(place * (1.0 - BESIDE)) != value(place * (1.0 + BESIDE))
}

/// A polynomial as one in a single product of symbols, lowest power first.
fn in_one_variable(polynomial: &Polynomial) -> Option<(Monomial, Vec<Rational>)> {
    let unit = polynomial
        .terms()
        .map(|(monomial, _)| monomial)
        .filter(|monomial| !monomial.factors().is_empty())
        .min_by_key(|monomial| monomial.degree().abs())?
        .clone();
    let mut coefficients = Vec::new();
    for (monomial, number) in polynomial.terms() {
        let power =
            (0..=LARGEST_DEGREE as i32).find(|&power| unit.power(power) == *monomial)? as usize;
        coefficients.resize(coefficients.len().max(power + 1), Rational::zero());
        coefficients[power] = number.clone();
    }
    Some((unit, coefficients))
}

/// The real roots, each once.
fn real_roots(coefficients: &[f64]) -> Vec<f64> {
    let zeros = real_zeros(coefficients, [f64::NEG_INFINITY, f64::INFINITY]);
    zeros.into_iter().map(|zero| zero.place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn approximant(equation: &str, degrees: (u32, u32)) -> Result<Expr, Refusal> {
        let options = Options {
            method: Some(METHOD),
            degrees: Some(Degrees::Quotient(degrees.0, degrees.1)),
            ..Options::default()
        };
        let solution = solve(&Oscillator::parse(equation).unwrap(), &options)?;
        Ok(solution.law.closed_form().unwrap().value.clone())
    }

    /// omega of the pendulum is pi/(2 K(sin(A/2)^2)), by the arithmetic-geometric mean 1/agm(1,
    /// cos(A/2)) of half its period.
    #[test]
    fn high_degrees_meet_the_pendulum_near_its_separatrix() {
        let law = approximant("x'' + sin(x) = 0", (8, 8)).unwrap();
        let amplitude: f64 = 2.5;
        let (mut a, mut g) = (1.0, (amplitude / 2.0).cos());
        for _ in 0..9 {
            (a, g) = ((a + g) / 2.0, f64::sqrt(a * g));
        }
        let found = law.evaluate(&[(Symbol::new("A"), amplitude)].into()).unwrap().sqrt();
        assert!((found / a - 1.0).abs() < 1e-6, "{found} {a}");
    }

    /// The highest degrees, whose whole numbers are far beyond double precision, against half the
    /// period by quadrature in the angle of x = A sin(theta), which is analytic and periodic.
    #[test]
    fn twenty_over_twenty() {
        type Work = fn(f64) -> f64;
        let cases: [(&str, Work, f64); 3] = [
            ("x'' + sin(x) = 0", |x| 1.0 - x.cos(), 2.8),
            ("x'' + x/(1 + x^2) = 0", |x| 0.5 * x.powi(2).ln_1p(), 2.0),
            ("x'' + 1e-9*sin(1e3*x) = 0", |x| 1e-12 * (1.0 - (1e3 * x).cos()), 2.5e-3),
        ];
        for (equation, potential, amplitude) in cases {
            let law = approximant(equation, (20, 20)).unwrap();
            let quarter: f64 = (0..4000)
                .map(|k| {
                    let theta = (f64::from(k) + 0.5) * std::f64::consts::PI / 8000.0;
                    let x = amplitude * theta.sin();
                    let speed = (2.0 * (potential(amplitude) - potential(x))).sqrt();
                    amplitude * theta.cos() / speed * std::f64::consts::PI / 8000.0
                })
                .sum();
            let expected = std::f64::consts::PI / (2.0 * quarter);
            let found = law.evaluate(&[(Symbol::new("A"), amplitude)].into()).unwrap().sqrt();
            assert!((found / expected - 1.0).abs() < 1e-6, "{equation}: {found} {expected}");
        }
    }

    /// omega of Duffing's equation at eps A^2 = 4 is sqrt(5) agm(1, sqrt(1 - 2/5)).
    #[test]
    fn twelve_over_twelve() {
        let (mut a, mut g) = (1.0, f64::sqrt(0.6));
        for _ in 0..9 {
            (a, g) = ((a + g) / 2.0, f64::sqrt(a * g));
        }
        let law = approximant("x'' + x + eps*x^3 = 0", (12, 12)).unwrap();
        let found = law.evaluate(&[("A".into(), 2.0), ("eps".into(), 1.0)].into()).unwrap();
        assert!((found.sqrt() / (f64::sqrt(5.0) * a) - 1.0).abs() < 1e-9, "{found}");
    }

    #[test]
    fn poles_are_the_real_zeros_alone() {
        let named = |terms: &[(i32, f64)]| {
            let term = |&(power, value): &(i32, f64)| {
                let unit = Monomial::power_of("k".into(), power)
                    .product(&Monomial::power_of("A".into(), 2 * power));
                Polynomial::term(unit, crate::exact::from_f64(value).unwrap())
            };
            poles(&terms.iter().map(term).fold(Polynomial::zero(), |sum, term| sum + term))
                .to_string()
        };
        // (1 - z/2)(1 + z^n): of the circle only -1 is real, and for even n none.
        let product = |n: i32| named(&[(0, 1.0), (1, -0.5), (n, 1.0), (n + 1, -0.5)]);
        assert!(product(19).starts_with("poles at k*A^2 = -1, 2:"), "{}", product(19));
        assert!(product(18).starts_with("poles at k*A^2 = 2:"), "{}", product(18));
        // Beyond the highest degree nothing is listed.
        assert!(product(60).starts_with("where its denominator vanishes"), "{}", product(60));
        // A pair of zeros next to the axis is none on it, at any scale; a double zero is two.
        for unit in [1.0, 1e3, 1e-3] {
            let near = |distance: f64| {
                real_roots(&[unit * unit * (1.0 + distance), -2.0 * unit, 1.0]).len()
            };
            assert_eq!((near(1e-8), near(-1e-8)), (0, 2), "{unit}");
        }
        assert_eq!(named(&[(0, 1.0), (1, 0.5), (2, 1.0)]), "its denominator has no real zero");
        assert!(real_roots(&[3.0]).is_empty() && real_roots(&[]).is_empty());
    }

    #[test]
    fn elimination_and_cofactors_agree() {
        let series: Vec<Polynomial> = [3, 1, -4, 1, 5, -9, 2, 6, 5]
            .map(|number| Polynomial::constant(Rational::from_integer(number.into())))
            .into();
        let rows: Vec<Vec<Polynomial>> =
            (1..=4).map(|k| (0..=4).map(|j| series[4 + k - j].clone()).collect()).collect();
        let mut expected = cofactors(&rows);
        let first = expected[0].clone();
        normalise(&mut expected, &first);
        assert_eq!(denominator(&series, 4, 4), Ok(expected));
    }

    #[test]
    fn a_missing_approximant_says_why() {
        for (equation, degrees, reason) in [
            ("x'' + k*x = 0", (2, 1), "does not depend on the amplitude"),
            ("x'' + x + k*x^3 + b*x^5 = 0", (13, 13), "give numbers"),
            ("x'' + sin(x) = 0", (20, 61), "[60/60]"),
        ] {
            let refusal = approximant(equation, degrees).unwrap_err();
            assert!(refusal.to_string().contains(reason), "{refusal}");
        }
    }
}

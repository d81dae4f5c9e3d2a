//! Normal modes of two coordinates with one harmonic, in closed form: balance of the first harmonic.
//!
//! ```text
//! x = A cos theta,  y = r A cos theta,  theta = omega t:     (2/pi) int_0^pi R_i cos theta dtheta = 0,  i = 1, 2
//! R_i = a_i(r, A^2) - omega^2 b_i(r, A^2),     omega^2 eliminated:   G(r, A^2) = a_1 b_2 - a_2 b_1 = 0
//! ```
//!
//! (R. M. Rosenberg, *Adv. Appl. Mech.* 9 (1966) 155; A. F. Vakakis, R. H. Rand, *Int. J. Non-Linear
//! Mech.* 27 (1992) 861.) A root r of G that does not depend on A is a similar mode: both coordinates
//! move in proportion at any amplitude. What is left of G is a family in which the ratio changes with
//! the amplitude, or further similar modes; where it has the root of a similar mode, the family
//! branches off that. Where an equation has no nonlinear terms the ratio is a function of omega.

use num_traits::{One, Signed, Zero};

use super::free_system::ForceTerm;
use super::{FreeSystem, ModeError};
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{Polynomial, Rational};
use crate::expr::{Expr, ExprError};
use crate::solution::Definition;
use crate::symbol::letters::{AMPLITUDE, FREQUENCY};
use crate::symbol::{Symbol, fresh};

/// The highest degree of a force.
const HIGHEST_DEGREE: u32 = 9;

/// Normal modes of two coordinates with one harmonic.
#[derive(Clone, Debug)]
pub struct OneHarmonicModes {
    /// The system.
    pub system: FreeSystem,
    /// The symbol of the ratio of the second coordinate to the first.
    pub ratio: Symbol,
    /// The families of modes in which the first coordinate moves.
    pub families: Vec<OneHarmonicFamily>,
    /// The places where families meet.
    pub branch_points: Vec<OneHarmonicBranchPoint>,
    /// Symbols of constants in the formulas.
    pub definitions: Vec<Definition>,
}

/// A family of modes.
#[derive(Clone, Debug, PartialEq)]
pub enum OneHarmonicFamily {
    /// A similar mode, whose ratio does not depend on the amplitude.
    Similar {
        /// The ratio r.
        ratio: Expr,
        /// omega^2 in the amplitude A.
        frequency_squared: Expr,
    },
    /// The ratio is the parameter.
    AlongRatio {
        /// A^2 in the ratio.
        amplitude_squared: Expr,
        /// omega^2 in the ratio.
        frequency_squared: Expr,
    },
    /// The frequency is the parameter.
    AlongFrequency {
        /// The ratio in omega.
        ratio: Expr,
        /// A^2 in omega.
        amplitude_squared: Expr,
    },
}

/// A place where another family branches off a similar mode.
#[derive(Clone, Debug, PartialEq)]
pub struct OneHarmonicBranchPoint {
    /// The ratio of the similar mode.
    pub ratio: Expr,
    /// The quantity that is fixed there, A^2 or a parameter, and its value.
    pub at: (Expr, Expr),
}

/// A quantity in the ratio and the amplitude, by powers of the ratio.
type InRatio = Vec<Polynomial>;

/// Derives the modes of two coordinates with one harmonic.
///
/// # Errors
/// [`ModeError`] for systems of another number of coordinates, forces of even degree or no polynomials,
/// and balances that have no closed form.
///
/// ```
/// # use lindstedt_modes as lindstedt;
/// use lindstedt::modes::{FreeSystem, OneHarmonicFamily, one_harmonic_modes};
///
/// let pair = FreeSystem::parse("x'' + x + x^3 + K*(x - y)^3 = 0; y'' + y + y^3 + K*(y - x)^3 = 0")?;
/// let modes = one_harmonic_modes(&pair)?;
/// let branch = &modes.branch_points[0];
/// assert_eq!((branch.ratio.to_string(), branch.at.1.to_string()), ("-1".to_owned(), "1/4".to_owned()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn one_harmonic_modes(system: &FreeSystem) -> Result<OneHarmonicModes, ModeError> {
    if system.mass.len() != 2 {
        return Err(ModeError::NotTwo(system.mass.len()));
    }
    let mut system = system.clone();
    let force = system.force_terms(HIGHEST_DEGREE + 2)?;
    let taken = system.names();
    let names = BalanceNames { ratio: fresh("r", &taken), square: fresh("s", &taken) };
    let balances = [balance(&system, &force, 0, &names)?, balance(&system, &force, 1, &names)?];
    let mut found = OneHarmonicModes {
        ratio: names.ratio,
        families: vec![],
        branch_points: vec![],
        definitions: system.constants.clone(),
        system,
    };
    match along_frequency(&balances, &names)? {
        Some(family) => found.families.push(family),
        None => along_ratio(&balances, &names, &mut found)?,
    }
    Ok(found)
}

/// The symbols of a balance: r, and s for omega^2.
struct BalanceNames {
    ratio: Symbol,
    square: Symbol,
}

impl BalanceNames {
    /// A polynomial with omega^2 in the place of s.
    fn written(&self, polynomial: &Polynomial) -> Result<Expr, ExprError> {
        let omega = Expr::from(FREQUENCY);
        Expr::from(polynomial).substitute(self.square, &(&omega * &omega))
    }
}

/// The first harmonic of an equation over A: a polynomial in r, s and A^2.
fn balance(
    system: &FreeSystem,
    force: &[Vec<ForceTerm>],
    row: usize,
    names: &BalanceNames,
) -> Result<Polynomial, ModeError> {
    let of = |name: Symbol| Polynomial::symbol(name);
    let minus = Polynomial::constant(-Rational::one());
    let mut sum = Polynomial::zero();
    for column in 0..2 {
        let inertia = system.mass[row][column].product(&of(names.square)).product(&minus);
        let mut linear = system.stiffness[row][column].clone();
        linear.accumulate(&inertia);
        let size =
            if column == 0 { Polynomial::constant(Rational::one()) } else { of(names.ratio) };
        sum.accumulate(&linear.product(&size));
    }
    for term in &force[row] {
        let degree = term.degree();
        if degree > HIGHEST_DEGREE as usize {
            return Err(ModeError::NotPolynomial(HIGHEST_DEGREE));
        }
        if degree % 2 == 0 {
            return Err(ModeError::EvenDegree(even_term(system, term)));
        }
        let (mut cosines, mut sines, mut squares, mut second, mut sign) = (0, 0, 0, 0, 1);
        for (coordinate, primes, exponent) in &term.powers {
            let exponent = *exponent as i32;
            match primes {
                0 => cosines += exponent,
                1 => sines += exponent,
                _ => {
                    cosines += exponent;
                    squares += exponent;
                    sign *= if exponent % 2 == 0 { 1 } else { -1 };
                }
            }
            second += if *coordinate == 1 { exponent } else { 0 };
        }
        let mean = first_harmonic(cosines, sines) * ratio(sign, 1);
        let monomial = Monomial::power_of(AMPLITUDE, i32::try_from(degree).unwrap_or(i32::MAX) - 1)
            .product(&Monomial::power_of(names.ratio, second))
            .product(&Monomial::power_of(names.square, squares + sines / 2));
        sum.accumulate(&term.coefficient.product(&Polynomial::term(monomial, mean)));
    }
    Ok(sum)
}

/// The term of a force, for a message.
fn even_term(system: &FreeSystem, term: &ForceTerm) -> Expr {
    let factors = term.powers.iter().map(|(coordinate, primes, exponent)| {
        let name = system.equations.coordinates[*coordinate];
        let name = (0..*primes).fold(name, |name, _| name.derivative());
        Polynomial::term(Monomial::power_of(name, *exponent as i32), Rational::one())
    });
    let product =
        factors.fold(term.coefficient.clone(), |product, factor| product.product(&factor));
    Expr::from(&product)
}

/// The first harmonic of `cos^m sin^n`, m odd and n even: `2 m!! (n - 1)!!/(m + n + 1)!!`.
pub(crate) fn first_harmonic(cosines: i32, sines: i32) -> Rational {
    let double = |from: i32| -> Rational {
        let mut product = Rational::one();
        let mut factor = from;
        while factor > 1 {
            product *= ratio(i64::from(factor), 1);
            factor -= 2;
        }
        product
    };
    double(cosines) * double(sines - 1) * ratio(2, 1) / double(cosines + sines + 1)
}

/// The coefficients of a polynomial by powers of a symbol, from zero on.
pub(crate) fn by_powers(polynomial: &Polynomial, name: Symbol) -> Vec<Polynomial> {
    let highest = polynomial.exponent_range(name).map_or(0, |(_, high)| high.max(0));
    let mut rows = vec![Polynomial::zero(); highest as usize + 1];
    for (monomial, number) in polynomial.terms() {
        let exponent = monomial.exponent(name).max(0) as usize;
        rows[exponent].add_term(monomial.without(name), number.clone());
    }
    rows
}

/// The family along omega, where an equation is linear, and the other linear in A^2.
fn along_frequency(
    balances: &[Polynomial; 2],
    names: &BalanceNames,
) -> Result<Option<OneHarmonicFamily>, ModeError> {
    for (linear, other) in [(1, 0), (0, 1)] {
        if balances[linear].symbols().contains(&AMPLITUDE) {
            continue;
        }
        let parts = by_powers(&balances[linear], names.ratio);
        let [free, slope] = parts.as_slice() else { continue };
        // r = -free/slope, over slope^n in the other.
        let rows = by_powers(&balances[other], names.ratio);
        let mut numerator = Polynomial::zero();
        let mut minus = free.clone();
        minus.negate();
        for (power, row) in rows.iter().enumerate() {
            let mut product = row.clone();
            for factor in 0..rows.len() - 1 {
                product = product.product(if factor < power { &minus } else { slope });
            }
            numerator.accumulate(&product);
        }
        let by_amplitude = by_powers(&numerator, AMPLITUDE);
        let [still, none, square] = by_amplitude.as_slice() else { continue };
        if !none.is_zero() {
            continue;
        }
        let quotient = |above: &Polynomial, below: &Polynomial| -> Result<Expr, ModeError> {
            let mut above = above.clone();
            above.negate();
            Ok(Expr::divide(&names.written(&above)?, &names.written(below)?)?)
        };
        return Ok(Some(OneHarmonicFamily::AlongFrequency {
            ratio: quotient(free, slope)?,
            amplitude_squared: quotient(still, square)?,
        }));
    }
    Ok(None)
}

/// The similar modes, and the family that is left along the ratio.
fn along_ratio(
    balances: &[Polynomial; 2],
    names: &BalanceNames,
    found: &mut OneHarmonicModes,
) -> Result<(), ModeError> {
    let [first, second] = balances.each_ref().map(|balance| by_powers(balance, names.square));
    let pair = |rows: &InRatio| match rows.as_slice() {
        [a, b] => {
            let mut b = b.clone();
            b.negate();
            Some((a.clone(), b))
        }
        _ => None,
    };
    let (Some((a1, b1)), Some((a2, b2))) = (pair(&first), pair(&second)) else {
        return Err(ModeError::NoClosedForm);
    };
    let mut eliminated = a2.product(&b1);
    eliminated.negate();
    eliminated.accumulate(&a1.product(&b2));
    if eliminated.is_zero() {
        // Every ratio balances.
        let ratio = Expr::from(names.ratio);
        let quotient = Expr::divide(&Expr::from(&a1), &Expr::from(&b1))?.expand()?;
        found.families.push(OneHarmonicFamily::Similar { ratio, frequency_squared: quotient });
        return Ok(());
    }
    // G by powers of A, each by powers of r.
    let mut parts: Vec<InRatio> =
        by_powers(&eliminated, AMPLITUDE).iter().map(|part| by_powers(part, names.ratio)).collect();
    let frequency_at = |ratio: &Expr| -> Result<Option<Expr>, ModeError> {
        for (a, b) in [(&a1, &b1), (&a2, &b2)] {
            let [a, b] = [a, b].map(|part| Expr::from(part).substitute(names.ratio, ratio));
            let (a, b) = (a?.expand()?, b?.expand()?);
            if !b.is_zero() {
                return Ok(Some(Expr::divide(&a, &b)?.expand()?));
            }
        }
        Ok(None)
    };
    let mut similar = Vec::new();
    for candidate in [1, -1, 0, 2, -2] {
        let root = ratio(candidate, 1);
        while parts.iter().all(|part| value_at(part, &root).is_zero())
            && parts.iter().flatten().any(|part| !part.is_zero())
        {
            parts = parts.iter().map(|part| without_root(part, &root)).collect();
            if similar.contains(&root) {
                continue;
            }
            let at = Expr::number(root.clone());
            if let Some(frequency_squared) = frequency_at(&at)? {
                found.families.push(OneHarmonicFamily::Similar { ratio: at, frequency_squared });
                similar.push(root.clone());
            }
        }
    }
    let left: Vec<(usize, InRatio)> =
        parts.into_iter().map(trimmed).enumerate().filter(|(_, part)| !part.is_empty()).collect();
    match left.as_slice() {
        [(_, part)] => {
            for root in closed_roots(part)? {
                if let Some(frequency_squared) = frequency_at(&root)? {
                    found
                        .families
                        .push(OneHarmonicFamily::Similar { ratio: root, frequency_squared });
                }
            }
            if part.len() > 3 {
                return Err(ModeError::NoClosedForm);
            }
            for root in &similar {
                found
                    .branch_points
                    .extend(fixed_parameter(&value_at(part, root)).map(|at| {
                        OneHarmonicBranchPoint { ratio: Expr::number(root.clone()), at }
                    }));
            }
        }
        [(low, still), (high, moving)] if high - low == 2 => {
            let amplitude_squared =
                minus_quotient(&in_ratio(still, names), &in_ratio(moving, names))?;
            let whole = frequency_at(&Expr::from(names.ratio))?.ok_or(ModeError::NoClosedForm)?;
            let root = amplitude_squared.sqrt()?;
            let frequency_squared = whole.substitute(AMPLITUDE, &root)?.expand()?;
            found
                .families
                .push(OneHarmonicFamily::AlongRatio { amplitude_squared, frequency_squared });
            for root in &similar {
                let below = value_at(moving, root);
                if below.is_zero() {
                    continue;
                }
                let square = minus_quotient(&value_at(still, root), &below)?;
                let negative = square.as_number().is_some_and(Signed::is_negative);
                if !negative && !square.is_zero() && !square.has_leading_minus() {
                    let amplitude = Expr::from(AMPLITUDE);
                    found.branch_points.push(OneHarmonicBranchPoint {
                        ratio: Expr::number(root.clone()),
                        at: (&amplitude * &amplitude, square),
                    });
                }
            }
        }
        [] => {}
        _ => return Err(ModeError::NoClosedForm),
    }
    match found.families.is_empty() {
        true => Err(ModeError::NoClosedForm),
        false => Ok(()),
    }
}

fn in_ratio(rows: &InRatio, names: &BalanceNames) -> Polynomial {
    let mut sum = Polynomial::zero();
    for (power, row) in rows.iter().enumerate() {
        let exponent = i32::try_from(power).unwrap_or(i32::MAX);
        sum.accumulate(&row.times_monomial(&Monomial::power_of(names.ratio, exponent)));
    }
    sum
}

fn minus_quotient(above: &Polynomial, below: &Polynomial) -> Result<Expr, ModeError> {
    let mut above = above.clone();
    above.negate();
    Ok(match below.power(-1) {
        Some(inverse) => Expr::from(&above.product(&inverse)),
        None => Expr::divide(&Expr::from(&above), &Expr::from(below))?,
    })
}

/// A polynomial in the ratio at a number.
fn value_at(rows: &InRatio, root: &Rational) -> Polynomial {
    rows.iter()
        .rev()
        .fold(Polynomial::zero(), |sum, row| sum.map(|number| number * root) + row.clone())
}

/// A polynomial in the ratio divided by `r - root`, which it has as a factor.
fn without_root(rows: &InRatio, root: &Rational) -> InRatio {
    let mut quotient = vec![Polynomial::zero(); rows.len().saturating_sub(1)];
    let mut carried = Polynomial::zero();
    for power in (1..rows.len()).rev() {
        carried = carried.map(|number| number * root) + rows[power].clone();
        quotient[power - 1] = carried.clone();
    }
    quotient
}

/// Without leading zeros.
fn trimmed(mut rows: InRatio) -> InRatio {
    while rows.last().is_some_and(Polynomial::is_zero) {
        rows.pop();
    }
    rows
}

/// The roots of a polynomial in the ratio up to the second degree.
fn closed_roots(rows: &InRatio) -> Result<Vec<Expr>, ModeError> {
    match rows.as_slice() {
        [free, slope] => Ok(vec![minus_quotient(free, slope)?]),
        [free, middle, leading] => {
            let four = Polynomial::constant(ratio(-4, 1));
            let mut under = free.product(leading).product(&four);
            under.accumulate(&middle.product(middle));
            // Numbers without a real root are no ratios.
            let Ok(root) = Expr::from(&under).sqrt() else { return Ok(vec![]) };
            let below = Expr::from(2) * Expr::from(leading);
            let of = |sign: i64| -> Result<Expr, ModeError> {
                let above = &(&root * &Expr::from(sign)) - &Expr::from(middle);
                Ok(Expr::divide(&above, &below)?)
            };
            Ok(vec![of(1)?, of(-1)?])
        }
        _ => Ok(vec![]),
    }
}

/// The parameter that a condition fixes, where one stands in it linearly with a number before it.
fn fixed_parameter(condition: &Polynomial) -> Option<(Expr, Expr)> {
    for name in condition.symbols() {
        let parts = by_powers(condition, name);
        if let [free, slope] = parts.as_slice()
            && slope.as_number().is_some()
        {
            return Some((Expr::from(name), minus_quotient(free, slope).ok()?));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_harmonics_of_powers() {
        assert_eq!(first_harmonic(3, 0), ratio(3, 4));
        assert_eq!(first_harmonic(1, 2), ratio(1, 4));
        assert_eq!(first_harmonic(5, 0), ratio(5, 8));
        assert_eq!(first_harmonic(1, 0), ratio(1, 1));
    }
}

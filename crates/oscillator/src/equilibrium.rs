//! The equilibrium about which a motion oscillates, the stable one nearest to `x = 0` or the one
//! asked for, and the equation in the deviation from it.
//!
//! In comes an [`Oscillator`], with or without an equilibrium asked for; out goes a [`Centred`]:
//! the position, the equation about it, and what its symbols stand for; or an [`OscillatorError`]
//! that names the stable equilibria there are.
//!
//! `f(x_e) = 0`, stable where the lowest term of the force about `x_e` is odd and pulls back; where
//! there is no Taylor series, where the force changes its sign from negative to positive. A force
//! may also be infinite at `x = 0`: with `f ~ k sgn(x)|x|^p` there, `k > 0`, the potential is
//! finite for `p > -1` and the motion swings through; `p = -1` is the limit of these,
//! `V = k log|x|`, in which the period stays finite while the speed at `x = 0` does not (R. E.
//! Mickens, *Truly Nonlinear Oscillations*, World Scientific 2010, section 2.3.3). A motion that is
//! pulled faster than that falls in.
//!
//! An unstable equilibrium is answered for only where it is asked for, and where motions run
//! through it: those of an odd force over the wells on both sides (`crate::conservative::passage`).
//!
//! The force is moved exactly: `f(x_e + x) - f(x_e)`. A fraction or a multiple of pi is put in; any
//! other equilibrium enters as a symbol of its own, whose value is a definition of the answer. Only
//! a polynomial asked for has numbers for coefficients.

mod force;
mod inverse;
mod one_sided;
mod search;
mod shift;

use std::collections::BTreeMap;

use num_traits::Zero;

use crate::decimal::{rounded, rounded_to};
use crate::exact::Rational;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::to_f64;
use crate::expr::Expr;
use crate::oscillator::corner::{beside_corners, near_rest};
use crate::oscillator::{Oscillator, OscillatorError};
use crate::series::taylor::taylor;
use crate::solution::Definition;
use crate::solution::note::{CornerSide, CrossWell};
use crate::symbol::{Symbol, fresh};
use force::{PositionForce, SingularAttraction};
use search::Zero as SignChange;
use shift::{shifted_force, value_at};

/// An equation of motion in the deviation from its equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Centred {
    /// The equation in `x - position`.
    pub oscillator: Oscillator,
    /// The equilibrium in numbers and parameters; seventeen digits where it has no closed form
    /// here.
    pub position: Expr,
    /// The equilibrium with the symbol of `definition` in it, if there is one.
    pub written: Expr,
    /// The symbol that stands for the equilibrium, or its negative, in the force.
    pub definition: Option<Definition>,
    /// Whether the coefficients of the force are rounded.
    pub numerical: bool,
    /// The sides of corners at rest without which there would be a force there: a barrier
    /// `H(x - xc)` is away for `xc > 0`.
    pub sides: Vec<CornerSide>,
    /// Whether the force pulls towards it as `1/x` does: the potential there is minus infinity, the
    /// speed of every motion infinite.
    pub endless: bool,
    /// The motions through it over the wells on both sides, where it is a maximum of the potential
    /// between them.
    pub cross_well: Option<CrossWell>,
}

impl Centred {
    fn at_origin(oscillator: &Oscillator) -> Self {
        Self {
            oscillator: oscillator.clone(),
            position: Expr::zero(),
            written: Expr::zero(),
            definition: None,
            numerical: false,
            sides: vec![],
            endless: false,
            cross_well: None,
        }
    }
}

/// The oscillator about the equilibrium asked for (a stable one, or a hilltop of the potential that
/// motions pass), else about the stable one nearest to zero that no pole hides; `degree` is that of
/// a polynomial with rounded coefficients in place of the force, should the equilibrium be
/// irrational.
///
/// # Errors
/// An unstable `x = 0`, or a requested position that is no equilibrium (the stable ones are named);
/// no equilibrium, or one that has no closed form in the parameters.
pub fn centred(oscillator: &Oscillator, degree: Option<u32>) -> Result<Centred, OscillatorError> {
    let t = Symbol::new("t");
    if !oscillator.force.contains(t) {
        return centred_still(oscillator, degree);
    }
    let Ok(expanded) = oscillator.force.expand() else {
        return Ok(Centred::at_origin(oscillator));
    };
    // The terms that contain time do not determine the equilibrium.
    let (driving, quiet): (Vec<Expr>, Vec<Expr>) =
        expanded.terms().iter().cloned().partition(|term| term.contains(t));
    let mut free = oscillator.clone();
    free.force = Expr::sum(quiet);
    if !free.force.contains(oscillator.coordinate) {
        return Ok(Centred::at_origin(oscillator));
    }
    let mut found = centred_still(&free, degree)?;
    found.oscillator.force = match found.written.is_zero() {
        true => oscillator.force.clone(),
        false => {
            let x = oscillator.coordinate;
            let moved = Expr::sum(driving).substitute(x, &(Expr::from(x) + &found.written))?;
            (&found.oscillator.force + &moved).expand()?
        }
    };
    Ok(found)
}

/// Does the work of [`centred`] for a force without terms in time.
fn centred_still(oscillator: &Oscillator, degree: Option<u32>) -> Result<Centred, OscillatorError> {
    let position = oscillator.coordinate;
    // If the force has no value at rest, the methods refuse it.
    let Ok(still) = oscillator.force.substitute(oscillator.velocity(), &Expr::zero()) else {
        return Ok(Centred::at_origin(oscillator));
    };
    if let Some(asked) = &oscillator.about {
        return about(oscillator, &still, asked, degree);
    }
    let at_zero = value_at(&still, position, &Expr::zero());
    let force = PositionForce::new(&still, position);
    let pull = match &at_zero {
        Err(_) if !force.vanishes_towards_zero() => force.pull_without_bound(),
        _ => None,
    };
    let rests = match &at_zero {
        Ok(force) => force.is_zero(),
        Err(_) => {
            force.vanishes_towards_zero()
                || matches!(pull, Some(SingularAttraction::Passed | SingularAttraction::Inverse))
        }
    };
    if rests {
        let stable = force.is_stable_at_zero();
        // Where stability depends on parameters it is assumed; but whether an even root is real for
        // both signs of x does not depend on them.
        if (!stable || !force.is_numerical())
            && let Some(error) = one_sided::refusal(oscillator, &still)
            && force.stable_equilibria().positions.is_empty()
        {
            return Err(error);
        }
        return match stable {
            true => Ok(Centred {
                endless: pull == Some(SingularAttraction::Inverse),
                // Values of the parameters may make it a maximum of the potential.
                cross_well: match oscillator.of_position_alone() && !force.is_numerical() {
                    true => force.cross_well(&Expr::zero()),
                    false => None,
                },
                ..Centred::at_origin(oscillator)
            }),
            false => Err(force.unstable(oscillator.of_position_alone())),
        };
    }
    let falls_in = |uneven: bool| OscillatorError::FallsIn {
        force: still.to_string(),
        coordinate: position,
        uneven,
    };
    let no_equilibrium = || match pull {
        Some(SingularAttraction::Endless) => falls_in(false),
        Some(SingularAttraction::UnevenInverse) => falls_in(true),
        _ => OscillatorError::NoEquilibrium(force.at_rest(&at_zero)),
    };
    if force.is_numerical() {
        let mut stable = force.stable();
        // A point at which the force is infinite is no equilibrium, whatever the sign function in
        // the expression is worth at zero.
        stable.retain(|found| pull.is_none() || found.position.abs() > 1e-100);
        let nearest = stable.iter().find(|found| found.reachable);
        return match (nearest, stable.is_empty()) {
            (Some(nearest), _) => {
                seen_from(oscillator, &force.exact_or_rounded(nearest.position), degree)
            }
            (None, true) => Err(no_equilibrium()),
            (None, false) => Err(OscillatorError::BeyondPole {
                force: force.at_rest(&at_zero),
                coordinate: position,
                stable: force.stable_equilibria(),
            }),
        };
    }
    if let Some(sides) = rests_beside_corners(&still, position)? {
        return Ok(Centred { sides, ..Centred::at_origin(oscillator) });
    }
    if !still.contains(position) {
        return Err(OscillatorError::NoEquilibrium(force.at_rest(&at_zero)));
    }
    match force.stable_closed_form() {
        Some(found) => seen_from(oscillator, &found, degree),
        None => Err(OscillatorError::SymbolicEquilibrium(force.at_rest(&at_zero))),
    }
}

/// The oscillator with the numbers given for its parameters, where the equilibrium in symbols is
/// not that of these numbers.
///
/// # Errors
/// With these numbers `x = 0`, or the equilibrium asked for, is not stable, or there is none.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::{Oscillator, Values, method::with_numbers_where_needed};
///
/// let loaded = Oscillator::parse("x'' + x + x^5 - g = 0")?;
/// let (numbers, _) = "g = 2".parse::<Values>()?.split(&["g".into()]);
/// let at_numbers = with_numbers_where_needed(&loaded, &numbers)?.ok_or("a closed form in g")?;
/// assert_eq!(at_numbers.equation().to_string(), "x'' - 2 + x + x^5 = 0");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn with_numbers_where_needed(
    oscillator: &Oscillator,
    numbers: &BTreeMap<Symbol, Expr>,
) -> Result<Option<Oscillator>, OscillatorError> {
    if oscillator.parameters.is_empty() {
        return Ok(None);
    }
    let in_symbols = match centred(oscillator, None) {
        Err(
            OscillatorError::SymbolicEquilibrium(_) | OscillatorError::NoSuchEquilibrium { .. },
        ) => None,
        Err(error) => return Err(error),
        Ok(centred) => Some(centred),
    };
    if !oscillator.parameters.iter().all(|name| numbers.contains_key(name)) {
        return Ok(None);
    }
    let numerical = oscillator.with_values(numbers)?;
    let place = |centred: &Centred| {
        let position = centred.position.substitute_all(numbers).ok()?;
        position.evaluate(&BTreeMap::new()).ok()
    };
    let in_numbers = centred(&numerical, None)?;
    let hilltop =
        |centred: &Centred| centred.cross_well.is_some() == in_numbers.cross_well.is_some();
    // A corner may be on its other side with these numbers.
    let beside = |centred: &Centred| {
        let Ok((_, taken)) = near_rest(&centred.oscillator.force, oscillator.coordinate) else {
            return false;
        };
        centred.sides.iter().chain(&taken).all(|side| {
            let at_numbers = side.positive.substitute_all(numbers);
            let value =
                at_numbers.map(|positive| positive.evaluate(&BTreeMap::new()).unwrap_or(f64::NAN));
            value.is_ok_and(|value| value > 0.0)
        })
    };
    let same = in_symbols.filter(beside).filter(hilltop).is_some_and(|in_symbols| {
        let (symbolic, number) = (place(&in_symbols), place(&in_numbers));
        matches!((symbolic, number), (Some(a), Some(b)) if (a - b).abs() <= 1e-9 * b.abs())
    });
    Ok((!same).then_some(numerical))
}

/// The oscillator about the equilibrium that was asked for: it may be typed rounded.
fn about(
    oscillator: &Oscillator,
    still: &Expr,
    asked: &Expr,
    degree: Option<u32>,
) -> Result<Centred, OscillatorError> {
    /// Relative error of a typed number that still means the equilibrium.
    const ROUNDING: f64 = 1e-3;
    let force = PositionForce::new(still, oscillator.coordinate);
    let none_there = || OscillatorError::NoSuchEquilibrium {
        coordinate: oscillator.coordinate,
        asked: asked.clone(),
        stable: force.stable_equilibria(),
    };
    if value_at(still, oscillator.coordinate, asked).is_ok_and(|value| value.is_zero()) {
        let found = about_zero_of_force(oscillator, still, asked, degree)?;
        return found.ok_or_else(none_there);
    }
    if let Some(form) = force.stable_form_of(asked) {
        return seen_from(oscillator, &EquilibriumPosition::Exact(form), degree);
    }
    let Ok(near) = asked.evaluate(&BTreeMap::new()) else {
        return Err(none_there());
    };
    let distance = |found: &SignChange| (found.position - near).abs();
    let signs = force.signs();
    let nearest = |stable: bool| {
        let close = signs
            .iter()
            .filter(|found| found.stable == stable && distance(found) <= ROUNDING * near.abs());
        close.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    if let Some(found) = nearest(true) {
        return seen_from(oscillator, &force.exact_or_rounded(found.position), degree);
    }
    // Cross-well motions need an odd force, and only about a position in closed form is it known to
    // be odd.
    if let Some(EquilibriumPosition::Exact(hilltop)) =
        nearest(false).map(|found| force.exact_or_rounded(found.position))
    {
        let found = about_zero_of_force(oscillator, still, &hilltop, degree)?;
        return found.ok_or_else(none_there);
    }
    Err(none_there())
}

/// The oscillator about a place where its force vanishes, if that is stable or motions pass it over
/// the wells on both sides.
fn about_zero_of_force(
    oscillator: &Oscillator,
    still: &Expr,
    place: &Expr,
    degree: Option<u32>,
) -> Result<Option<Centred>, OscillatorError> {
    let there = shifted_force(still, oscillator.coordinate, place)?;
    let there = PositionForce::new(&there, oscillator.coordinate);
    let stable = there.is_stable_at_zero();
    // The residual is asked about time, because the drive has been taken out of the force.
    let conservative =
        oscillator.of_position_alone() && !oscillator.residual.contains(Symbol::new("t"));
    let cross_well = match conservative && !(stable && there.is_numerical()) {
        true => there.cross_well(place),
        false => None,
    };
    if !stable && cross_well.is_none() {
        return Ok(None);
    }
    Ok(Some(Centred {
        cross_well,
        ..seen_from(oscillator, &EquilibriumPosition::Exact(place.clone()), degree)?
    }))
}

/// The refusal of an equilibrium that was asked for because it is not stable.
pub fn no_bottom(oscillator: &Oscillator) -> OscillatorError {
    let asked = oscillator.about.clone().unwrap_or_else(Expr::zero);
    let stable = PositionForce::new(&oscillator.force, oscillator.coordinate).stable_equilibria();
    OscillatorError::NoSuchEquilibrium { coordinate: oscillator.coordinate, asked, stable }
}

/// The error of an unstable `x = 0` where the stable equilibria contain parameters, whose values
/// decide; `None` if there are no such equilibria.
pub(crate) fn stable_elsewhere(oscillator: &Oscillator) -> Option<OscillatorError> {
    let still = oscillator.force.substitute(oscillator.velocity(), &Expr::zero()).ok()?;
    if still.contains(Symbol::new("t")) {
        return None;
    }
    let force = PositionForce::new(&still, oscillator.coordinate);
    let found = force.stable_equilibria();
    (!force.is_numerical() && !found.positions.is_empty())
        .then(|| force.unstable(oscillator.of_position_alone()))
}

/// The position of an equilibrium.
#[derive(Clone, Debug, PartialEq)]
enum EquilibriumPosition {
    /// In closed form.
    Exact(Expr),
    /// A numerical value.
    Rounded(f64),
}

/// The sides of corners on which there is no force at rest, where letters decide them; `None` if
/// there is one all the same.
fn rests_beside_corners(
    still: &Expr,
    coordinate: Symbol,
) -> Result<Option<Vec<CornerSide>>, OscillatorError> {
    let (beside, sides) = beside_corners(still, coordinate)?;
    let rests = !sides.is_empty()
        && value_at(&beside, coordinate, &Expr::zero()).is_ok_and(|force| force.is_zero());
    Ok(rests.then_some(sides))
}

/// The equation in the deviation from a position.
fn seen_from(
    oscillator: &Oscillator,
    place: &EquilibriumPosition,
    degree: Option<u32>,
) -> Result<Centred, OscillatorError> {
    let coordinate = oscillator.coordinate;
    let position = match place {
        EquilibriumPosition::Exact(position) => position.clone(),
        EquilibriumPosition::Rounded(value) => Expr::number(rounded_to(*value, 17)),
    };
    let number = position.evaluate(&BTreeMap::new()).ok();
    let mut centred = Centred {
        position: position.clone(),
        written: position.clone(),
        ..Centred::at_origin(oscillator)
    };
    let simple = matches!(place, EquilibriumPosition::Exact(_))
        && position.to_polynomial(&mut |_| None)?.is_some();
    if simple {
        centred.oscillator.force = shifted_force(&oscillator.force, coordinate, &position)?;
        return Ok(centred);
    }
    if let (Some(degree), Some(number)) = (degree, number) {
        centred.oscillator.force = rounded_force(oscillator, number, degree)?;
        centred.written = Expr::number(rounded(number));
        centred.numerical = true;
        return Ok(centred);
    }
    if number == Some(0.0) {
        let at_rest = value_at(&oscillator.force, coordinate, &Expr::zero())?
            .substitute(oscillator.velocity(), &Expr::zero())?;
        centred.oscillator.force = &oscillator.force - &at_rest;
        return Ok(centred);
    }
    // The symbol of the equilibrium is positive if its sign is known, as edges of barriers are
    // taken to be.
    let negative = number.is_some_and(|number| number < 0.0);
    let symbol = fresh(&format!("{coordinate}_e"), &oscillator.names());
    let (written, meaning) = match negative {
        false => (Expr::from(symbol), position),
        true => (-Expr::from(symbol), -position),
    };
    let at_rest = oscillator
        .force
        .substitute(oscillator.velocity(), &Expr::zero())?
        .substitute(coordinate, &written)?;
    let force = oscillator.force.substitute(coordinate, &(Expr::from(coordinate) + &written))?;
    centred.oscillator.force = force - at_rest;
    centred.written = written;
    centred.definition = Some(Definition { symbol, meaning });
    Ok(centred)
}

/// The force as a polynomial in coordinate and velocity with rounded coefficients: all of it where
/// it is a polynomial, its Taylor polynomial of a degree otherwise.
fn rounded_force(
    oscillator: &Oscillator,
    number: f64,
    degree: u32,
) -> Result<Expr, OscillatorError> {
    let (position, velocity) = (oscillator.coordinate, oscillator.velocity());
    let centre = rounded_to(number, 17);
    let mut constants: BTreeMap<Symbol, Expr> = BTreeMap::new();
    let mut name = |constant: &Expr| {
        if constant.contains(position)
            || constant.contains(velocity)
            || constant.contains(Symbol::new("t"))
        {
            return None;
        }
        let symbol = Symbol::new(&format!("constant {constant}"));
        constants.insert(symbol, constant.clone());
        Some(symbol)
    };
    let moved = oscillator
        .force
        .substitute(position, &(Expr::from(position) + Expr::number(centre.clone())))?;
    let polynomial = match moved.to_polynomial(&mut name)? {
        Some(polynomial)
            if polynomial.exponent_range(position).is_none_or(|range| range.0 >= 0) =>
        {
            polynomial
        }
        _ => {
            let point = [(position, centre), (velocity, Rational::zero())];
            let point = if oscillator.force.contains(velocity) { &point[..] } else { &point[..1] };
            let sum = Expr::sum(taylor(&oscillator.force, point, degree)?);
            let polynomial = sum.to_polynomial(&mut name)?;
            polynomial.ok_or_else(|| OscillatorError::NotPolynomial(sum.clone().into()))?
        }
    };
    // The sum of the coefficients and that of their absolute values, by the powers of coordinate
    // and velocity and the rest of the term.
    let mut sums: BTreeMap<(i32, i32, Monomial), (f64, f64)> = BTreeMap::new();
    for (monomial, factor) in polynomial.terms() {
        let mut value = to_f64(factor);
        let mut rest = Monomial::one();
        for &(symbol, exponent) in monomial.factors() {
            let number = match constants.get(&symbol) {
                Some(constant) => constant.evaluate(&BTreeMap::new()).ok(),
                None => (symbol == Symbol::new("pi")).then_some(std::f64::consts::PI),
            };
            match (number, constants.get(&symbol)) {
                (Some(number), _) => value *= number.powi(exponent),
                (None, Some(constant)) => {
                    return Err(OscillatorError::NotPolynomial(constant.clone().into()));
                }
                (None, None) if symbol == position || symbol == velocity => {}
                (None, None) => rest = rest.product(&Monomial::power_of(symbol, exponent)),
            }
        }
        let powers = (monomial.exponent(position), monomial.exponent(velocity), rest);
        let entry = sums.entry(powers).or_insert((0.0, 0.0));
        *entry = (entry.0 + value, entry.1 + value.abs());
    }
    let coefficient = |powers: &(i32, i32, Monomial)| sums.get(powers).map_or(0.0, |entry| entry.0);
    let mut terms = Vec::new();
    for (powers, &(value, size)) in &sums {
        let (p, q, rest) = powers;
        // The equilibrium is rounded, and with it every coefficient in proportion to the next one.
        let next = coefficient(&(p + 1, *q, rest.clone()));
        let rounding =
            1e-14 * size + 4.0 * f64::EPSILON * number.abs() * f64::from(p + 1) * next.abs();
        if value.abs() <= rounding || (*p, *q) == (0, 0) {
            continue;
        }
        // The linear frequency is rounded instead of its square, so that it needs no symbol.
        let coefficient = match (p, q) {
            (1, 0) if value > 0.0 && rest.factors().is_empty() => {
                num_traits::pow(rounded(value.sqrt()), 2)
            }
            _ => rounded(value),
        };
        let power =
            |symbol: Symbol, exponent: i32| Expr::from(symbol).integer_power(exponent.into());
        let mut term = Expr::number(coefficient) * power(position, *p)? * power(velocity, *q)?;
        for &(symbol, exponent) in rest.factors() {
            term = term * power(symbol, exponent)?;
        }
        terms.push(term);
    }
    Ok(Expr::sum(terms))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn position(text: &str) -> Result<String, OscillatorError> {
        Ok(centred(&Oscillator::parse(text)?, None)?.position.to_string())
    }

    fn force(text: &str) -> String {
        let centred = centred(&Oscillator::parse(text).unwrap(), None).unwrap();
        centred.oscillator.force.expand().unwrap().to_string()
    }

    #[test]
    fn the_nearest_stable_equilibrium() {
        assert_eq!(position("x'' + sin(x)").unwrap(), "0");
        assert_eq!(position("x'' + x - 1/3").unwrap(), "1/3");
        assert_eq!(position("x'' + x^2 - 4").unwrap(), "2");
        assert_eq!(position("x'' + x^2 - 2").unwrap(), "sqrt(2)");
        let text = position("x'' + x - cos(x)").unwrap();
        let value = to_f64(&text.parse::<Expr>().unwrap().as_number().unwrap().clone());
        assert!((value - value.cos()).abs() < 2e-16);
    }

    #[test]
    fn angles_are_moved_exactly() {
        assert_eq!(position("x'' + cos(x)").unwrap(), "-pi/2");
        assert_eq!(force("x'' + cos(x)"), "sin(x)");
        assert_eq!(force("x'' - sin(x + pi/3)"), "sin(x)");
        assert_eq!(force("x'' + 2*cos(2*x)"), "2*sin(2*x)");
        assert_eq!(force("x'' + sin(x) - 1/2"), "-1/2 + sqrt(3)*sin(x)/2 + cos(x)/2");
    }

    #[test]
    fn every_scale_has_its_equilibria() {
        assert_eq!(position("x'' + 1e12*x - 1e26*x^3").unwrap(), "0");
        let small: Expr = position("x'' + 1e12*x - 1e26*x^2 - 1e-9").unwrap().parse().unwrap();
        assert!((small.evaluate(&BTreeMap::new()).unwrap() / 1.000_000_1e-21 - 1.0).abs() < 1e-13);
        for scale in ["1e-20", "1e-9", "1e9", "1e20"] {
            let text = format!("x'' + (x/{scale})^2 - 4");
            let expected = format!("2*{scale}").parse::<Expr>().unwrap();
            assert_eq!(position(&text).unwrap(), expected.to_string(), "{text}");
        }
    }

    #[test]
    fn what_is_no_equilibrium_is_not_taken_for_one() {
        for text in
            ["x'' + x^2 + x^3", "x'' + x^2", "x'' - x^3", "x'' + max(x, 0)", "x'' + x*log(abs(x))"]
        {
            assert!(matches!(position(text), Err(OscillatorError::Unstable { .. })), "{text}");
        }
        assert_eq!(position("x'' + x - 1/x^3").unwrap(), "1");
        assert_eq!(position("x'' + x - 1/x").unwrap(), "1");
        assert_eq!(position("x'' + x - k/x").unwrap(), "sqrt(k)");
        let text = position("x'' + x + log(x)").unwrap();
        let value = to_f64(text.parse::<Expr>().unwrap().as_number().unwrap());
        assert!((value + value.ln()).abs() < 1e-15);
        assert!(matches!(position("x'' + k/x^2"), Err(OscillatorError::SymbolicEquilibrium(_))));
    }

    #[test]
    fn a_gap_and_a_corner_are_equilibria() {
        for text in [
            "x'' + max(x - 1, 0) + min(x + 1, 0)",
            "x'' + x*abs(x)",
            "x'' + sgn(x)",
            "x'' + x^(1/3)",
            "x'' + (1 - cos(x))/x",
        ] {
            assert_eq!(position(text).unwrap(), "0", "{text}");
        }
    }

    #[test]
    fn equilibria_beyond_a_pole_come_last() {
        // x (1 - x)^2 = 1/4 has a root beyond x = 1 alone, the plates of a condenser having met; x
        // (1 - x) = 1/5 before it.
        let error = position("x'' + x - 1/(4*(1 - x)^2)").unwrap_err();
        assert!(matches!(error, OscillatorError::BeyondPole { .. }), "{error}");
        assert!(matches!(position("x'' + x - 1/(9*(1 - x)^2)").unwrap().len(), 18..), "irrational");
        assert_eq!(position("x'' + x - 1/(5*(1 - x))").unwrap(), "2/(5 + sqrt(5))");
        assert_eq!(
            position("x'' + x - lambda/(1 - x)").unwrap(),
            "2*lambda/(1 + sqrt(1 - 4*lambda))"
        );
    }

    #[test]
    fn static_loads_in_symbols() {
        assert_eq!(position("x'' + x - k").unwrap(), "k");
        assert_eq!(position("x'' + k*(x - L) + b*(x - L)^3").unwrap(), "L");
        assert_eq!(position("x'' + x + x^2 - g").unwrap(), "2*g/(1 + sqrt(1 + 4*g))");
        assert_eq!(position("x'' + sin(x) - T").unwrap(), "asin(T)");
        assert_eq!(position("x'' - sin(x) - T").unwrap(), "pi + asin(T)");
        assert_eq!(position("x'' + x^3 - g").unwrap(), "g^(1/3)");
        assert!(matches!(
            position("x'' + x - g*exp(-x)"),
            Err(OscillatorError::SymbolicEquilibrium(_))
        ));
    }

    /// The plates of a condenser have two equilibria before they meet, and one that is none beyond:
    /// which of the roots of the cubic that are depends on the values.
    #[test]
    fn a_root_beyond_a_pole_is_not_chosen() {
        let values: BTreeMap<Symbol, f64> =
            [("k".into(), 2.0), ("m".into(), 0.1), ("L".into(), 1.0)].into();
        let found = centred(&Oscillator::parse("x'' + k*x - m/(L - x)^2").unwrap(), None).unwrap();
        let place = found.position.evaluate(&values).unwrap();
        assert!(
            (2.0 * place - 0.1 / (1.0 - place).powi(2)).abs() < 1e-15 && place < 0.1,
            "{place}"
        );
    }

    #[test]
    fn a_force_moved_keeps_its_form() {
        assert_eq!(
            force("x'' + x - 1/3 + x*abs(x)"),
            "x + x*abs(x + x_e) - x_e*abs(x_e) + x_e*abs(x + x_e)"
        );
        let barrier = force("x'' + x - cos(x) + 3*max(x - 1, 0)");
        assert!(barrier.contains("max(0, x + x_e - 1)"), "{barrier}");
    }

    #[test]
    fn unstable_and_missing_ones_are_refused() {
        let stable = |text: &str| match position(text) {
            Err(OscillatorError::Unstable { stable, .. }) => stable.to_string(),
            other => panic!("{text}: {other:?}"),
        };
        assert_eq!(stable("x'' - x + x^3"), "-1, 1");
        assert_eq!(stable("x'' - x + k*x^3"), "sqrt(1/k), -sqrt(1/k)");
        assert_eq!(stable("x'' + sin(x) - 2*sin(x)*cos(x)"), "-pi/3, pi/3, and again every 2*pi");
        assert!(matches!(position("x'' + 1 + x^2"), Err(OscillatorError::NoEquilibrium(_))));
    }

    #[test]
    fn an_equilibrium_may_be_chosen() {
        let about = |text: &str, place: &str| {
            let oscillator = Oscillator::parse(text).unwrap().about(place.parse().unwrap());
            centred(&oscillator, None).map(|centred| centred.position.to_string())
        };
        assert_eq!(about("x'' - x + x^3", "-1").unwrap(), "-1");
        assert_eq!(about("x'' + sin(x)", "2*pi").unwrap(), "2*pi");
        assert_eq!(about("x'' - x + k*x^3", "1/sqrt(k)").unwrap(), "1/sqrt(k)");
        assert_eq!(about("x'' - 2*x + x^3", "1.4142").unwrap(), "sqrt(2)");
        assert_eq!(about("x'' - cos(x)*(1 - 2*sin(x))", "1.5708").unwrap(), "pi/2");
        let none = [
            ("x'' - x + x^3", "0.5"),
            ("x'' + sin(x)", "pi"),
            ("x'' - x + x^2/10 + x^3", "0"),
            ("x'' + x'/10 - x + x^3", "0"),
            ("x'' - x + x^3 = cos(t)", "0"),
            ("x'' - x", "0"),
        ];
        for (text, place) in none {
            let error = about(text, place).unwrap_err();
            assert!(matches!(error, OscillatorError::NoSuchEquilibrium { .. }), "{error}");
        }
    }

    #[test]
    fn rounding_leaves_no_terms_behind() {
        // (x - sqrt(2)) + (x - sqrt(2))^3 + a load that shifts nothing: even coefficients are zero.
        let oscillator =
            Oscillator::parse("x'' + sinh(x - 0.7390851332151607) + x - 0.7390851332151607")
                .unwrap();
        assert_eq!(
            centred(&oscillator, Some(5)).unwrap().oscillator.force.to_string(),
            "x + sinh(x)"
        );
        let oscillator =
            Oscillator::parse("x'' + exp(x - 1/7) - exp(1/7 - x) + x - 1/7 + 0*x").unwrap();
        assert_eq!(position("x'' + exp(x - 1/7) - exp(1/7 - x)").unwrap(), "1/7");
        let centred = centred(&oscillator, Some(4)).unwrap();
        assert!(!centred.numerical);
    }
}

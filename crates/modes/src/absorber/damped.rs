//! The tuned mass damper on a main mass with damping of its own: the lowest variance.
//!
//! The curves of all dampings have no point in common, and the lowest peak is the root of a polynomial without
//! a closed form. The variance is a quotient of polynomials in the damping `zeta_1` of the main mass too;
//! to its first power
//!
//! ```text
//! V = V_0(f, zeta) + zeta_1 V_1(f, zeta),    V_0 level at (f_0, zeta_0), of the main mass without damping
//! V_0'' (f - f_0, zeta - zeta_0) = -zeta_1 V_1',    1/V = 1/V_0 - zeta_1 V_1/V_0^2 at (f_0, zeta_0)
//! ```
//!
//! In the logarithms of f and zeta the derivatives of V_1 are polynomials in f^2 and zeta^2, and those of V_0
//! over f zeta.

use std::ops::Bound;

use super::tuned::{self, AbsorberNames, halved, minus, optimum, transfer, value, variance_parts};
use super::{
    AbsorberDesign, AbsorberError, AbsorberFormula, AbsorberKind, AbsorberLaws, AbsorberLetter,
    AbsorberRelation, Excitation,
};
use crate::coupled::CoupledEquations;
use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, RationalFunction};
use crate::expr::Expr;
use crate::modes::by_powers;
use crate::symbol::Symbol;
use num_traits::Zero as _;

/// The damping ratio of the main mass alone.
const OF_MAIN_MASS: AbsorberLetter = AbsorberLetter {
    name: "zeta_1",
    meaning: "the damping ratio of the main mass",
    range: (Bound::Included(0.0), Bound::Excluded(1.0)),
    example: "1/100",
};

/// The letters of the designs.
pub(super) const LETTERS: [AbsorberLetter; 2] = [tuned::MASS_RATIO, OF_MAIN_MASS];

/// The letters of the designs on shaken ground.
pub(super) const LETTERS_BELOW_TWO: [AbsorberLetter; 2] =
    [tuned::MASS_RATIO_BELOW_TWO, OF_MAIN_MASS];

const WHAT: &str = "the design with the lowest variance on a damped main mass";

/// Derives the design.
pub(super) fn derive(excitation: Excitation) -> Result<AbsorberLaws, AbsorberError> {
    let none = || AbsorberError::NoClosedForm(WHAT);
    let names = AbsorberNames::new();
    let damping = Symbol::new("zeta_1");
    let right = tuned::right_sides(excitation);
    let equations = CoupledEquations::parse(&format!(
        "x'' + 2*zeta_1*x' + x + mu*(2*zeta*f*(x' - y') + f^2*(x - y)) = {}; y'' + 2*zeta*f*(y' - x') + f^2*(y - x) = {}",
        right[0], right[1]
    ))?;
    let [above_all, below_all] =
        without_shared_powers(variance_parts(&transfer(&equations, &names)?, &names), names.f);
    let [above, below] = [&above_all, &below_all].map(|part| {
        let mut orders = by_powers(part, damping).into_iter();
        [(); 2].map(|()| orders.next().unwrap_or_else(Polynomial::zero))
    });
    // Where both are divided by a power of zeta_1 the quotient is the same.
    let inverse = below[0].power(-1).ok_or_else(none)?;
    let undamped = above[0].product(&inverse);
    let mut change = above[1].clone();
    change.accumulate(&minus(&undamped.product(&below[1])));
    let change = change.product(&inverse);
    let [p, z] = optimum(&undamped, &names)?;
    // Derivatives in the logarithms of the letters.
    let letters = [names.f, names.zeta];
    let slope = |polynomial: &Polynomial, letter: Symbol| {
        polynomial.slope(letter).product(&Polynomial::symbol(letter))
    };
    let squares = [(names.f, names.p), (names.zeta, names.z)];
    let at = |polynomial: &Polynomial| -> Result<RationalFunction, AbsorberError> {
        let polynomial = halved(polynomial, &squares)?;
        let found = value(&polynomial, &[(names.p, &p), (names.z, &z)], &names).ok_or_else(none)?;
        Ok(found.rational)
    };
    let odd = Monomial::power_of(names.f, 1).product(&Monomial::power_of(names.zeta, 1));
    let mut curvature = vec![];
    for one in letters {
        for other in letters {
            curvature.push(at(&slope(&slope(&undamped, one), other).times_monomial(&odd))?);
        }
    }
    let pulls = letters.map(|letter| at(&slope(&change, letter)));
    let [first, second] = pulls;
    let (first, second) = (first?, second?);
    let [a, b, c, d] = &curvature[..] else { return Err(none()) };
    let determinant = a.product(d).difference(&b.product(c));
    // ln f and ln zeta change by these times f zeta zeta_1.
    let moved = |above: RationalFunction| above.quotient(&determinant).ok_or_else(none);
    let of_tuning = moved(b.product(&second).difference(&d.product(&first)))?;
    let of_damping = moved(c.product(&first).difference(&a.product(&second)))?;
    let square = at(&undamped.product(&undamped))?;
    let of_variance = at(&change)?;
    let root = |value: &RationalFunction| value.sqrt_expr(names.mu);
    let [tuning, own] = [root(&p.rational)?, root(&z.rational)?];
    let variance = Expr::divide(&Expr::from(&above_all), &Expr::from(&below_all))?;
    let by_damping = |factor: &RationalFunction| -> Result<Expr, AbsorberError> {
        Ok(factor.to_expr(names.mu)? * Expr::from(damping))
    };
    // f f zeta and zeta f zeta, of which the squares are rational functions.
    let of_tuning = by_damping(&p.rational.product(&of_tuning))? * own.clone();
    let of_damping = by_damping(&z.rational.product(&of_damping))? * tuning.clone();
    // V_0^2/(V_0 - zeta_1 V_1), which is never negative.
    let least = root(&square)? - by_damping(&of_variance)?;
    let formulas = [
        ("tuning", "f", tuning + of_tuning),
        ("damping", "zeta", own + of_damping),
        ("variance", "V", Expr::divide(&square.to_expr(names.mu)?, &least)?),
    ];
    let formulas = formulas.map(|(name, symbol, formula)| AbsorberFormula {
        name,
        symbol: Symbol::new(symbol),
        formula,
    });
    let mut meanings = tuned::meanings(&names, excitation);
    meanings.retain(|(name, _)| name.name() != "X");
    meanings.insert(0, (damping, "damping ratio of the main mass alone"));
    Ok(AbsorberLaws {
        kind: AbsorberKind::Damped(excitation),
        equations: equations.equations,
        meanings,
        definitions: vec![],
        relations: vec![AbsorberRelation {
            left: Expr::symbol("V"),
            right: variance,
            words: "the variance under white noise",
        }],
        designs: vec![AbsorberDesign {
            name: "lowest-variance",
            words: "the variance under white noise is the least (H2), to first order in zeta_1",
            formulas: formulas.into(),
            refined_by: None,
        }],
        validity: "linear, zeta_1 small beside 1 and sqrt(mu), time in units of 1/(the frequency of the main mass alone without damping); with damping of the main mass the \
                   curves of all dampings have no point in common, so that there are no fixed points of equal height, and the lowest peak has no closed form: at values it is searched",
    })
}

/// Numerator and denominator divided by the highest power of a letter that all their terms have.
fn without_shared_powers(parts: [Polynomial; 2], letter: Symbol) -> [Polynomial; 2] {
    let lowest = parts.iter().filter_map(|part| Some(part.exponent_range(letter)?.0)).min();
    let shared = Monomial::power_of(letter, -lowest.unwrap_or(0));
    parts.map(|part| part.times_monomial(&shared))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_damping_it_is_the_design_of_the_main_mass_without() {
        for excitation in [Excitation::Force, Excitation::Ground] {
            let damped = derive(excitation).expect("closed forms");
            let plain = tuned::derive(excitation).expect("closed forms");
            let plain = plain.design("lowest-variance").expect("a design");
            let zero = [(Symbol::new("zeta_1"), Expr::zero())].into();
            for (own, other) in damped.designs[0].formulas.iter().zip(&plain.formulas) {
                let at_zero = own.formula.substitute_all(&zero).expect("a value");
                let at = [(Symbol::new("mu"), 0.3)].into();
                let [found, wanted] =
                    [&at_zero, &other.formula].map(|formula| formula.evaluate(&at).expect("it"));
                assert!((found / wanted - 1.0).abs() < 1e-14, "{at_zero} {}", other.formula);
            }
        }
    }
}

//! The vibro-impact sink: a ball that flies in a cavity of a main mass and hits its walls, twice a
//! period.
//!
//! ```text
//! x = X cos t + U sin t,  y = Z (1 - 2 t/pi)  from the impact at t = 0 to that at t = pi,  |y - x| = b at both
//! Z - X = b,   -v - U = -r (v - U),  v = 2 Z/pi:      C^2 = X^2 + U^2 = (Z - b)^2 + (2 s Z/pi)^2,  s = (1 - r)/(1 + r)
//! ```
//!
//! The ball is light: an impact does not change the motion of the main mass, whose amplitude C falls
//! from impact to impact (E. Gourc, G. Michon, S. Seguy, A. Berlioz, *J. Vib. Acoust.* 137 (2015) 031008; T. Li, S. Seguy,
//! A. Berlioz, *Nonlinear Dyn.* 87 (2017) 2415).
//!
//! After an impact at `t = d` instead of 0 the ball has the velocity `-v + e` instead of `-v`, and after
//! the next at `t = pi + d'` it has `v - e'`. In first order
//!
//! ```text
//! (v - U) d' = (v + U) d + pi e,     e' = r e - (1 + r) X d'
//! ```
//!
//! The motion is stable between the multiplier 1 of this map, where C is least, and the multiplier -1.
//!
//! Each impact takes `mu/(1 + mu) (1 - r^2) (v - U)^2/2` from the energy `C^2/2`, so that along the manifold
//!
//! ```text
//! d(C^2)/dt = -mu/(1 + mu) (1 - r^2) (v - U)^2/pi = -16 mu s Z^2/((1 + mu) pi^3)
//! ```

use std::ops::Bound;

use super::{
    AbsorberDesign, AbsorberError, AbsorberFormula, AbsorberKind, AbsorberLaws, AbsorberLetter,
    AbsorberRelation,
};
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{Polynomial, RationalFunction};
use crate::expr::{Expr, Function};
use crate::modes::by_powers;
use crate::solution::Definition;
use crate::symbol::Symbol;

/// The letters of the designs.
pub(super) const LETTERS: [AbsorberLetter; 3] = [
    AbsorberLetter {
        name: "r",
        meaning: "the coefficient of restitution",
        range: (Bound::Excluded(0.0), Bound::Excluded(1.0)),
        example: "0.65",
    },
    AbsorberLetter {
        name: "b",
        meaning: "half the width of the cavity, less the radius of the ball,",
        range: (Bound::Excluded(0.0), Bound::Unbounded),
        example: "1",
    },
    AbsorberLetter {
        name: "mu",
        meaning: "the mass ratio of a light ball",
        range: (Bound::Excluded(0.0), Bound::Included(0.1)),
        example: "1/100",
    },
];

const WHAT: &str = "the motion with two impacts a period";

/// Derives the manifold, its least amplitude and where the motion is stable.
pub(super) fn derive() -> Result<AbsorberLaws, AbsorberError> {
    let none = || AbsorberError::NoClosedForm(WHAT);
    let of = Symbol::new;
    let expr = |name: &str| Expr::symbol(name);
    let (z, pi) = (of("Z"), of("pi"));
    let loss = loss()?;
    // C^2 pi^2 = (Z - b)^2 pi^2 + (2 s Z)^2, a polynomial of second degree in Z.
    let place = expr("Z") - expr("b");
    let speed = Expr::divide(&(Expr::from(2) * expr("Z")), &Expr::pi())?;
    let velocity = -expr("s") * &speed;
    let square = place.integer_power(2)? + velocity.integer_power(2)?;
    let times_pi = (&square * &Expr::from(pi).integer_power(2)?).to_polynomial(&mut |_| None)?;
    let parts = by_powers(&times_pi.ok_or_else(none)?, z);
    let [c0, c1, c2] = &parts[..] else { return Err(none()) };
    let mut middle = c1.map(|number| number / ratio(2, 1));
    middle.negate();
    let lowest_place = Expr::divide(&Expr::from(&middle), &Expr::from(c2))?;
    // C^2 = (c0 c2 - c1^2/4)/(pi^2 c2) where it is least.
    let mut lowest = middle.product(&middle);
    lowest.negate();
    lowest.accumulate(&c0.product(c2));
    let lowest = lowest.times_monomial(&Monomial::power_of(pi, -2)).single_term_root();
    let lowest = Expr::divide(&Expr::from(&lowest.ok_or_else(none)?), &Expr::from(c2).sqrt()?)?;
    // X = kappa v/pi where a multiplier is -1: Z - b = 2 kappa Z/pi^2.
    let kappa = kappa_at_period_doubling(&loss)?.to_expr(of("r"))?;
    let per_pi = Expr::divide(&Expr::from(2), &Expr::pi().integer_power(2)?)?;
    let highest_place = Expr::divide(&expr("b"), &(Expr::one() - per_pi * &kappa))?;
    let highest_speed = Expr::divide(&(Expr::from(2) * &highest_place), &Expr::pi())?;
    let directions =
        expr("s").integer_power(2)? + Expr::divide(&kappa, &Expr::pi())?.integer_power(2)?;
    let highest = highest_speed * directions.sqrt()?;
    let time = decay_time(&times_pi_parts(c1, c2)?, &loss)?;
    let formula = |name: &'static str, symbol: &str, formula: Expr| AbsorberFormula {
        name,
        symbol: of(symbol),
        formula,
    };
    Ok(AbsorberLaws {
        kind: AbsorberKind::ImpactSink,
        equations: vec![
            (Expr::from(of("x").derivative().derivative()) + expr("x"), Expr::zero()),
            (Expr::from(of("y").derivative().derivative()), Expr::zero()),
        ],
        meanings: vec![
            (of("x"), "displacement of the main mass, time in units of 1/(its frequency)"),
            (of("y"), "displacement of the ball, which hits a wall where abs(y - x) = b"),
            (of("b"), "half the width of the cavity, less the radius of the ball"),
            (of("r"), "coefficient of restitution"),
            (of("C"), "amplitude of the main mass"),
            (of("Z"), "amplitude of the ball, which flies to and fro at the speed 2*Z/pi"),
            (of("Z0"), "its amplitude at t = 0"),
            (of("mu"), "mass of the ball over that of the main mass"),
        ],
        definitions: vec![Definition { symbol: of("s"), meaning: loss.to_expr(of("r"))? }],
        relations: vec![
            AbsorberRelation {
                left: expr("X"),
                right: place,
                words: "place of the main mass at an impact, where the ball turns",
            },
            AbsorberRelation {
                left: expr("U"),
                right: velocity,
                words: "its velocity there, by the restitution",
            },
            AbsorberRelation {
                left: expr("C").integer_power(2)?,
                right: square,
                words: "motions with two impacts a period, by C^2 = X^2 + U^2",
            },
            AbsorberRelation {
                left: expr("t"),
                right: time,
                words: "decay along them, by the energy that impacts take",
            },
        ],
        designs: vec![
            AbsorberDesign {
                name: "threshold",
                words: "the least amplitude of the main mass with two impacts a period",
                formulas: vec![
                    formula("amplitude", "C_min", lowest),
                    formula("ball_amplitude", "Z_min", lowest_place),
                ],
                refined_by: None,
            },
            AbsorberDesign {
                name: "period-doubling",
                words: "the largest amplitude at which that motion is stable",
                formulas: vec![
                    formula("amplitude", "C_max", highest),
                    formula("ball_amplitude", "Z_max", highest_place),
                ],
                refined_by: None,
            },
        ],
        validity: "a light ball, whose impacts take little from the main mass in a period; t to first order in mu; an impact takes no time; where r is below 0.09 or so, the ball \
                   hits the same wall twice before C_max is reached",
    })
}

/// `d(C^2)/dZ = p + q Z` as its coefficients p and q, from those of `pi^2 C^2`.
fn times_pi_parts(first: &Polynomial, second: &Polynomial) -> Result<[Expr; 2], AbsorberError> {
    let over = Monomial::power_of(Symbol::new("pi"), -2);
    let [constant, slope] = [first, second].map(|part| part.times_monomial(&over));
    Ok([Expr::from(&constant), Expr::from(2) * Expr::from(&slope)])
}

/// The time in which the amplitude of the ball falls from `Z0` to Z: the integral of
/// `-(p + q Z)/(rate of C^2) dZ`, where the rate is a number times `Z^2`.
fn decay_time([p, q]: &[Expr; 2], loss: &RationalFunction) -> Result<Expr, AbsorberError> {
    let none = || AbsorberError::NoClosedForm(WHAT);
    let expr = |name: &str| Expr::symbol(name);
    let letter = Symbol::new("r");
    let one = RationalFunction::number(ratio(1, 1));
    let r =
        RationalFunction::from_polynomial(&Polynomial::symbol(letter), letter).ok_or_else(none)?;
    // (1 - r^2) (v - U)^2 = number s v^2 with U = -s v: the number does not depend on r.
    let gap = one.sum(loss);
    let taken = one.difference(&r.product(&r)).product(&gap.product(&gap));
    let number = taken.quotient(loss).ok_or_else(none)?.to_expr(letter)?;
    // v^2 = 4 Z^2/pi^2, and an impact every pi.
    let mass = Expr::divide(&(Expr::one() + expr("mu")), &expr("mu"))?;
    let scale = Expr::divide(&Expr::pi().integer_power(3)?, &(Expr::from(4) * number * expr("s")))?;
    let [before, now] = [expr("Z0"), expr("Z")];
    let fallen = Expr::function(Function::Log, vec![Expr::divide(&before, &now)?])?;
    let inverse = Expr::divide(&Expr::one(), &now)? - Expr::divide(&Expr::one(), &before)?;
    Ok(mass * scale * (q * &fallen + p * &inverse))
}

/// `s = -U/v` in r, from the condition of restitution `-v - U = -r (v - U)`.
fn loss() -> Result<RationalFunction, AbsorberError> {
    let none = || AbsorberError::NoClosedForm(WHAT);
    let (r, u, v) = (Symbol::new("r"), Symbol::new("U"), Symbol::new("v"));
    let after = -Expr::from(v) - Expr::from(u);
    let before = Expr::from(v) - Expr::from(u);
    let condition = after + Expr::from(r) * before;
    let condition = condition.to_polynomial(&mut |_| None)?.ok_or_else(none)?;
    let part = |name: Symbol| {
        RationalFunction::from_polynomial(&condition.slope(name), r).ok_or_else(none)
    };
    part(v)?.quotient(&part(u)?).ok_or_else(none)
}

/// `kappa = pi X/v` where a multiplier of the map of impacts is -1.
fn kappa_at_period_doubling(loss: &RationalFunction) -> Result<RationalFunction, AbsorberError> {
    let none = || AbsorberError::NoClosedForm(WHAT);
    let one = RationalFunction::number(ratio(1, 1));
    let letter = Symbol::new("r");
    let r =
        RationalFunction::from_polynomial(&Polynomial::symbol(letter), letter).ok_or_else(none)?;
    // d' = alpha d + beta pi e/v with U = -s v.
    let gap = one.sum(loss);
    let alpha = one.difference(loss).quotient(&gap).ok_or_else(none)?;
    let beta = one.quotient(&gap).ok_or_else(none)?;
    // 1 + trace + determinant, with trace = alpha + r - (1 + r) beta kappa and determinant = alpha r.
    let free = one.sum(&alpha).sum(&r).sum(&alpha.product(&r));
    let slope = one.sum(&r).product(&beta);
    free.quotient(&slope).ok_or_else(none)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_of_two_impacts_a_period() {
        let laws = derive().expect("closed forms");
        let formulas = laws.designs.iter().flat_map(|design| &design.formulas);
        let written: Vec<String> =
            formulas.map(|own| format!("{} = {}", own.symbol, own.formula)).collect();
        assert_eq!(laws.definitions[0].meaning.to_string(), "(1 - r)/(1 + r)");
        assert_eq!(
            written,
            [
                "C_min = 2*b*s/sqrt(pi^2 + 4*s^2)",
                "Z_min = pi^2*b/(pi^2 + 4*s^2)",
                "C_max = 2*b*sqrt(4/pi^2 + s^2)/(pi*(1 - 4/pi^2))",
                "Z_max = b/(1 - 4/pi^2)",
            ]
        );
    }
}

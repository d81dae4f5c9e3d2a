//! The nonlinear energy sink: a light mass on a cubic spring, without a frequency of its own.
//!
//! ```text
//! x'' + x + eps (lambda (x' - y') + k (x - y)^3) = eps F cos t,    y'' + lambda (y' - x') + k (y - x)^3 = 0
//! x - y = N cos t,  x = P cos t + Q sin t:      C^2 = P^2 + Q^2 = N^2 ((1 - 3 k N^2/4)^2 + lambda^2)
//! ```
//!
//! The first harmonic of the second equation gives the manifold along which both masses move while
//! C changes slowly (O. V. Gendelman, *Nonlinear Dyn.* 37 (2004) 115; A. F. Vakakis and others, *Nonlinear
//! Targeted Energy Transfer*, Springer 2008, chapter 3). It folds where the slope of C^2 vanishes; in `u = k N^2` the
//! roots are those of an equation of second degree, and the place to which a motion jumps from a
//! fold is the third root of a cubic with a double one.
//!
//! The force balances the first harmonic of the other bracket, `F^2 = N^2 (lambda^2 + (3 k N^2/4)^2)`. While the motion is at a
//! fold, C grows if `F C > lambda N^2` for the best phase of the force.
//!
//! The relative error of one harmonic is the third over the first, three per cent at most at the lower fold
//! and seven beyond. Its first effect has closed forms too: with `u = k N^2` and the third harmonic W,
//!
//! ```text
//! x - y = N cos t + Re(W exp(3 i t)),    W/N = (u/4)/(9 - 3 u/2 - 3 i lambda)
//! k C^2 = u |1 - i lambda - (3 u/4)(1 + W/N)|^2,    k F^2 = u |i lambda + (3 u/4)(1 + W/N)|^2
//! ```

use std::ops::Bound;

use num_traits::{One, Zero};

use super::{
    AbsorberDesign, AbsorberError, AbsorberFormula, AbsorberKind, AbsorberLaws, AbsorberLetter,
    AbsorberRelation,
};
use crate::coupled::CoupledEquations;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{Polynomial, QuadraticSurd, Rational, RationalFunction};
use crate::expr::{Expr, parse_expression};
use crate::modes::{by_powers, first_harmonic};
use crate::solution::Definition;
use crate::symbol::Symbol;

/// The letters of the designs.
pub(super) const LETTERS: [AbsorberLetter; 3] = [
    AbsorberLetter {
        name: "lambda",
        meaning: "the damping of a sink whose manifold folds",
        // 1/sqrt(3), above which the manifold has no folds.
        range: (Bound::Excluded(0.0), Bound::Excluded(0.577_350_269_189_625_7)),
        example: "0.2",
    },
    AbsorberLetter {
        name: "k",
        meaning: "the coefficient of the cubic spring",
        range: (Bound::Excluded(0.0), Bound::Unbounded),
        example: "1",
    },
    AbsorberLetter {
        name: "eps",
        meaning: "the mass ratio of a light sink",
        range: (Bound::Excluded(0.0), Bound::Included(0.1)),
        example: "1/100",
    },
];

const WHAT: &str = "the manifold of the sink";

/// The cosine and the sine of a sum of products of cos t and sin t.
type Harmonic = [Polynomial; 2];

/// Derives the manifold, its folds and the forces that lead to them.
pub(super) fn derive() -> Result<AbsorberLaws, AbsorberError> {
    let none = || AbsorberError::NoClosedForm(WHAT);
    let of = Symbol::new;
    let equations = CoupledEquations::parse(
        "x'' + x + eps*(lambda*(x' - y') + k*(x - y)^3) = eps*F*cos(t); y'' + lambda*(y' - x') + k*(y - x)^3 = 0",
    )?;
    let (n, k, lambda) = (of("N"), of("k"), of("lambda"));
    // The second equation is linear in P and Q, which stand in y'' alone.
    let [cosine, sine] = harmonic(&equations.equations[1].0)?;
    let solved = |condition: &Polynomial, unknown: &str| -> Result<Polynomial, AbsorberError> {
        let parts = by_powers(condition, of(unknown));
        let [free, slope] = &parts[..] else { return Err(none()) };
        let mut inverse = slope.power(-1).ok_or_else(none)?;
        inverse.negate();
        Ok(free.product(&inverse))
    };
    let (p, q) = (solved(&cosine, "P")?, solved(&sine, "Q")?);
    // The first equation has the force where its bracket has it not, over eps.
    let [cosine, sine] = harmonic(&equations.equations[0].0)?;
    let per_mass = |part: &Polynomial| part.times_monomial(&Monomial::power_of(of("eps"), -1));
    let (force_p, force_q) = (per_mass(&cosine), per_mass(&sine));
    let square = |one: &Polynomial, other: &Polynomial| {
        let mut sum = one.product(one);
        sum.accumulate(&other.product(other));
        sum
    };
    // k C^2 and k F^2 as polynomials in u = k N^2, with coefficients in lambda.
    let in_u = |squared: &Polynomial| -> Result<Vec<RationalFunction>, AbsorberError> {
        let mut scaled = Polynomial::zero();
        for (monomial, number) in squared.terms() {
            let power = monomial.exponent(n) / 2;
            if monomial.exponent(n) % 2 != 0 || monomial.exponent(k) != power - 1 {
                return Err(none());
            }
            let rest = monomial.without(n).without(k);
            scaled.add_term(rest.product(&Monomial::power_of(of("u"), power)), number.clone());
        }
        let rows = by_powers(&scaled, of("u"));
        let rows = rows.iter().map(|row| RationalFunction::from_polynomial(row, lambda));
        rows.collect::<Option<Vec<_>>>().ok_or_else(none)
    };
    let manifold = in_u(&square(&p, &q))?;
    let force = in_u(&square(&force_p, &force_q))?;
    let [_, c1, c2, c3] = &manifold[..] else { return Err(none()) };
    // c1 + 2 c2 u + 3 c3 u^2 = 0
    let three = c3.scaled(&ratio(3, 1));
    let middle = c2.negative().quotient(&three).ok_or_else(none)?;
    let radicand = middle.product(&middle).difference(&c1.quotient(&three).ok_or_else(none)?);
    let one = RationalFunction::number(Rational::one());
    let upper = QuadraticSurd::new(middle, &one, &radicand);
    // From a fold at a double root u the motion jumps to the third root, -c2/c3 - 2 u.
    let sum = upper.constant(c2.negative().quotient(c3).ok_or_else(none)?);
    let minus_two = upper.constant(RationalFunction::number(ratio(-2, 1)));
    let stiffness = Expr::from(k).sqrt()?;
    let formula = |name: &'static str, symbol: &str, value: &QuadraticSurd| {
        let root = value.sqrt_expr(lambda)?;
        let formula = Expr::divide(&root, &stiffness)?;
        Ok::<_, AbsorberError>(AbsorberFormula { name, symbol: of(symbol), formula })
    };
    let mut designs = Vec::new();
    for (name, words, u, number) in [
        (
            "upward-jump",
            "the lower fold, from which the sink takes up large motion and pumps energy off",
            upper.conjugate(),
            1,
        ),
        ("downward-jump", "the upper fold, at which pumping ends", upper.clone(), 2),
    ] {
        let amplitude = u.value_of(&manifold);
        let landing = sum.sum(&minus_two.product(&u));
        let mut formulas = vec![
            formula("amplitude", &format!("C_{number}"), &amplitude)?,
            formula("relative_amplitude", &format!("N_{number}"), &u)?,
            formula("landing", &format!("M_{number}"), &landing)?,
            formula("force", &format!("F_{number}"), &u.value_of(&force))?,
        ];
        if number == 1 {
            // F C = lambda N^2, squared and times k.
            let letter = Polynomial::symbol(lambda);
            let letter = RationalFunction::from_polynomial(&letter, lambda).ok_or_else(none)?;
            let damping = u.constant(letter.product(&letter));
            let least = damping.product(&u).product(&u).quotient(&amplitude).ok_or_else(none)?;
            formulas.push(formula("least_force", "F_0", &least)?);
        }
        let refined_by = Some(REFINED[usize::from(number == 2)]);
        designs.push(AbsorberDesign { name, words, formulas, refined_by });
    }
    let (definitions, refined) = with_third_harmonic()?;
    designs.extend(refined);
    let written = |symbol: &str, squared: [&Polynomial; 2]| -> Result<_, AbsorberError> {
        let [one, other] = squared.map(|part| Expr::from(part).factored().integer_power(2));
        Ok((Expr::symbol(symbol).integer_power(2)?, one? + other?))
    };
    let (left, right) = written("C", [&p, &q])?;
    let (force_left, force_right) = written("F", [&force_p, &force_q])?;
    Ok(AbsorberLaws {
        kind: AbsorberKind::CubicSink,
        equations: equations.equations,
        meanings: vec![
            (of("eps"), "mass of the sink over the main mass"),
            (lambda, "damping of the sink"),
            (k, "coefficient of its cubic spring"),
            (of("F"), "force over eps, at the frequency of the main mass alone"),
            (of("C"), "amplitude of the main mass"),
            (n, "amplitude of the sink relative to the main mass"),
            (of("M"), "the same after a jump from a fold"),
        ],
        definitions,
        relations: vec![
            AbsorberRelation {
                left,
                right,
                words: "the manifold: motions at the frequency of the main mass",
            },
            AbsorberRelation {
                left: force_left,
                right: force_right,
                words: "its steady motions under the force; stable outside of the folds",
            },
        ],
        designs,
        validity: "a light sink, one harmonic and the first effect of the third; between the forces F_1 and F_2 no steady motion is stable and the amplitudes jump to and fro, \
                   below F_0 no motion reaches the lower fold",
    })
}

/// The names of the designs with the third harmonic.
const REFINED: [&str; 2] = ["upward-jump-with-third-harmonic", "downward-jump-with-third-harmonic"];

/// The third harmonic over the first, W/N: as 9 - 3 u/2 - 3 i lambda to u/4.
const SQUARE: &str = "(9 - 3*u/2)^2 + 9*lambda^2";

/// The definitions and the designs with the first effect of the third harmonic, from `W/N` of the
/// documentation of this module: `k C^2 = c + T`, `k F^2 = f + S`, and the folds and landings moved
/// by what T does to them.
fn with_third_harmonic() -> Result<(Vec<Definition>, Vec<AbsorberDesign>), AbsorberError> {
    let of = Symbol::new;
    let parsed = |text: &str| parse_expression(text).map_err(|_| AbsorberError::NoClosedForm(WHAT));
    let along = of("u");
    let manifold = parsed("u*((1 - 3*u/4)^2 + lambda^2)")?;
    let force = parsed("u*(lambda^2 + 9*u^2/16)")?;
    let of_manifold =
        parsed(&format!("3*u^3*((3*u/4 - 1)*(9 - 3*u/2) + 3*lambda^2)/(8*({SQUARE}))"))?;
    let of_force = parsed(&format!("3*u^3*(3*u*(9 - 3*u/2)/4 + 3*lambda^2)/(8*({SQUARE}))"))?;
    let slope = manifold.differentiate(along)?;
    let shift = Expr::divide(&-of_manifold.differentiate(along)?, &slope.differentiate(along)?)?;
    let force_slope = force.differentiate(along)?;
    let stiffness = Expr::symbol("k");
    let (mut definitions, mut designs) = (Vec::new(), Vec::new());
    for (number, name, sign) in [(1, REFINED[0], "-"), (2, REFINED[1], "+")] {
        let [fold, landing, moved, own, other] =
            ["u", "v", "d", "T", "L"].map(|letter| format!("{letter}_{number}"));
        let at =
            |expression: &Expr, place: &str| expression.substitute(along, &Expr::symbol(place));
        for (symbol, meaning) in [
            (&fold, parsed(&format!("4*(2 {sign} sqrt(1 - 3*lambda^2))/9"))?),
            (&landing, parsed(&format!("8/3 - 2*{fold}"))?),
            (&moved, at(&shift, &fold)?),
            (&own, at(&of_manifold, &fold)?),
            (&other, at(&of_manifold, &landing)?),
        ] {
            definitions.push(Definition { symbol: of(symbol), meaning });
        }
        let [fold_moved, drift] =
            [format!("{fold} + {moved}"), format!("{own} - {other}")].map(|text| parsed(&text));
        let drift = Expr::divide(&drift?, &at(&slope, &landing)?)?;
        let fold_moved = fold_moved?;
        let forced = at(&force, &fold)?
            + at(&force_slope, &fold)? * Expr::symbol(&moved)
            + at(&of_force, &fold)?;
        let amplitude = at(&manifold, &fold)? + Expr::symbol(&own);
        let mut formulas = Vec::new();
        for (name, letter, square) in [
            ("amplitude", "C", &amplitude),
            ("relative_amplitude", "N", &fold_moved),
            ("landing", "M", &(Expr::symbol(&landing) + drift)),
            ("force", "F", &forced),
        ] {
            let formula = Expr::divide(square, &stiffness)?.sqrt()?;
            formulas.push(AbsorberFormula {
                name,
                symbol: of(&format!("{letter}_{number}")),
                formula,
            });
        }
        if number == 1 {
            let formula = Expr::divide(
                &(Expr::symbol("lambda") * fold_moved),
                &(amplitude * stiffness.clone()).sqrt()?,
            )?;
            formulas.push(AbsorberFormula { name: "least_force", symbol: of("F_0"), formula });
        }
        designs.push(AbsorberDesign {
            name,
            words: "the same with the first effect of the third harmonic",
            formulas,
            refined_by: None,
        });
    }
    Ok((definitions, designs))
}

/// The first harmonic of an equation along `x - y = N cos t`, `x = P cos t + Q sin t`.
fn harmonic(left: &Expr) -> Result<Harmonic, AbsorberError> {
    let of = Symbol::new;
    let (c, s) = (Expr::symbol("cos"), Expr::symbol("sin"));
    let [n, p, q] = ["N", "P", "Q"].map(Expr::symbol);
    let moved = |cosine: &Expr, sine: &Expr| cosine * &c + sine * &s;
    let mut values = std::collections::BTreeMap::new();
    for (name, cosine, sine) in [(of("x"), p.clone(), q.clone()), (of("y"), &p - &n, q)] {
        values.insert(name, moved(&cosine, &sine));
        values.insert(name.derivative(), moved(&sine, &-&cosine));
        values.insert(name.derivative().derivative(), moved(&-&cosine, &-&sine));
    }
    let along = left.substitute_all(&values)?.to_polynomial(&mut |_| None)?;
    let along = along.ok_or(AbsorberError::NoClosedForm(WHAT))?;
    let mut parts = [Polynomial::zero(), Polynomial::zero()];
    for (monomial, number) in along.terms() {
        let powers = [monomial.exponent(of("cos")), monomial.exponent(of("sin"))];
        let rest = monomial.without(of("cos")).without(of("sin"));
        let [cosines, sines] = powers;
        match [cosines % 2, sines % 2] {
            [1, 0] => parts[0].add_term(rest, number * first_harmonic(cosines, sines)),
            [0, 1] => parts[1].add_term(rest, number * first_harmonic(sines, cosines)),
            // Even waves have no first harmonic.
            _ => {}
        }
    }
    Ok(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folds_of_the_manifold() {
        let laws = derive().expect("closed forms");
        let formulas = laws.designs[..2].iter().flat_map(|design| &design.formulas);
        let written: Vec<String> =
            formulas.map(|own| format!("{} = {}", own.symbol, own.formula)).collect();
        let relations: Vec<String> =
            laws.relations.iter().map(|own| format!("{} = {}", own.left, own.right)).collect();
        assert_eq!(
            written,
            [
                "C_1 = sqrt(8/81 + 8*lambda^2/9 + 8*(1 - 3*lambda^2)^(3/2)/81)/sqrt(k)",
                "N_1 = 2*sqrt(2 - sqrt(1 - 3*lambda^2))/(3*sqrt(k))",
                "M_1 = sqrt(8/9 + 8*sqrt(1 - 3*lambda^2)/9)/sqrt(k)",
                "F_1 = 2*sqrt(14 - sqrt(1 - 3*lambda^2)*(13 + 6*lambda^2))/(9*sqrt(k))",
                "F_0 = lambda*sqrt(2/(1 + sqrt(1 - 3*lambda^2)))/sqrt(k)",
                "C_2 = lambda*sqrt(8/(3*(1 + 9*lambda^2 + (1 - 3*lambda^2)^(3/2))))*(1 + lambda^2)/sqrt(k)",
                "N_2 = 2*sqrt(2 + sqrt(1 - 3*lambda^2))/(3*sqrt(k))",
                "M_2 = lambda*sqrt(8/(3*(1 + sqrt(1 - 3*lambda^2))))/sqrt(k)",
                "F_2 = 2*sqrt(14 + sqrt(1 - 3*lambda^2)*(13 + 6*lambda^2))/(9*sqrt(k))",
            ]
        );
        assert_eq!(
            relations,
            ["C^2 = lambda^2*N^2 + (4*N - 3*k*N^3)^2/16", "F^2 = lambda^2*N^2 + 9*k^2*N^6/16"]
        );
    }
}

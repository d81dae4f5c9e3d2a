//! The nonlinear tuned vibration absorber: a cubic spring beside the linear one keeps the two peaks
//! equally high where the main mass has a cubic spring too.
//!
//! ```text
//! x'' + x + alpha3 x^3 + mu (f^2 (x - y) + 2 f zeta (x' - y') + b3 (x - y)^3) = F cos(g t)
//! y'' - f^2 (x - y) - 2 f zeta (x' - y') - b3 (x - y)^3 = 0
//! ```
//!
//! The linear design is that of the lowest peak, whose two peaks are exactly equally high. With
//! `w = g^2` and the static deflection 1 its first harmonics are `X = B/A` and `X - Y = Z = -w/A`. The first
//! harmonic of a cube is `3 |X|^2 X/4`; as a force on the main mass it acts on x by X itself, and as a
//! force between the masses by Z:
//!
//! ```text
//! dX = -(3/4) F^2 (alpha3 |X|^2 X^2 + mu b3 |Z|^2 Z^2),     d ln|X| = Re(dX/X)
//!    = -(3/4) F^2 h^4 (alpha3 Re(B A*)/D + mu b3 w^4 Re(B A)/D^3),     D = |B|^2,  |X| = h
//! ```
//!
//! The height of a peak does not change with g in first order, so that this is its change at the
//! frequencies of the linear design, the roots of `w^2 + a w + b`. There every rational function of w is
//! `c_0 + c_1 w`, and both peaks change alike where `c_1 = 0`: a linear equation of b3. What is left, `c_0`, is the
//! change of both.
//!
//! The principle is that of G. Habib, T. Detroux, R. Viguie, G. Kerschen, *Mech. Syst. Signal Process.*
//! 52-53 (2015) 17, who fit `b3 = 2 mu alpha3/(1 + 4 mu)` to numbers.

use std::ops::Bound;

use num_traits::{One, Zero};

use super::tuned::{AbsorberNames, Response, numbers_of_the_lowest_peak, transfer, value};
use super::{
    AbsorberDesign, AbsorberError, AbsorberFormula, AbsorberKind, AbsorberLaws, AbsorberLetter,
    AbsorberRelation,
};
use crate::coupled::CoupledEquations;
use crate::exact::rational::ratio;
use crate::exact::{Polynomial, QuadraticSurd, Rational, RationalFunction};
use crate::expr::Expr;
use crate::modes::by_powers;
use crate::solution::Definition;
use crate::symbol::Symbol;

/// The letters of the designs.
pub(super) const LETTERS: [AbsorberLetter; 3] = [
    AbsorberLetter {
        name: "mu",
        meaning: "the mass ratio",
        range: (Bound::Included(0.001), Bound::Included(1.0)),
        example: "1/20",
    },
    AbsorberLetter {
        name: "alpha3",
        meaning: "the cubic coefficient of a main mass that stiffens",
        range: (Bound::Excluded(0.0), Bound::Unbounded),
        example: "1",
    },
    AbsorberLetter {
        name: "F",
        meaning: "the amplitude of the force",
        range: (Bound::Excluded(0.0), Bound::Unbounded),
        example: "1/100",
    },
];

const WHAT: &str = "the cubic spring of the absorber";

/// A number `c_0 + c_1 w` at the two roots w of `w^2 + a w + b`.
type AtPeaks = [QuadraticSurd; 2];

/// Derives the cubic spring and the change of the peaks.
pub(super) fn derive() -> Result<AbsorberLaws, AbsorberError> {
    let none = || AbsorberError::NoClosedForm(WHAT);
    let names = AbsorberNames::new();
    let (alpha3, b3, force) = (Symbol::new("alpha3"), Symbol::new("b3"), Symbol::new("F"));
    let equations = CoupledEquations::parse(
        "x'' + x + alpha3*x^3 + mu*(2*zeta*f*(x' - y') + f^2*(x - y) + b3*(x - y)^3) = F*cos(g*t); \
         y'' + 2*zeta*f*(y' - x') + f^2*(y - x) + b3*(y - x)^3 = 0",
    )?;
    let response = Response::new(&transfer(&linear(&equations)?, &names)?, &names)?;
    let lowest = numbers_of_the_lowest_peak(&response, &names)?.ok_or_else(none)?;
    let peaks = &lowest.peaks;
    let at = |polynomial: &Polynomial| -> Result<AtPeaks, AbsorberError> {
        let zero = lowest.p.constant(RationalFunction::number(Rational::zero()));
        let one = lowest.p.constant(RationalFunction::number(Rational::one()));
        let (w, mut sum) = ([zero.clone(), one], [zero.clone(), zero.clone()]);
        for row in by_powers(polynomial, names.w).iter().rev() {
            let values = [(names.p, &lowest.p), (names.z, &lowest.z)];
            let row = value(row, &values, &names).ok_or_else(none)?;
            let [free, slope] = product(&sum, &w, peaks);
            sum = [free.sum(&row), slope];
        }
        Ok(sum)
    };
    let ([be, bo], [ae, ao]) = (&response.numerator, &response.denominator);
    let w = Polynomial::symbol(names.w);
    let damping = Polynomial::symbol(names.z).product(&w);
    // even + odd z w, the real part of a product; the odd parts are imaginary.
    let real_part = |even: &Polynomial, odd: &Polynomial, sign: i64| {
        let mut sum = odd.product(&damping).map(|number| number * ratio(sign, 1));
        sum.accumulate(even);
        sum
    };
    let square = at(&real_part(&be.product(be), &bo.product(bo), 1))?;
    let main = at(&real_part(&be.product(ae), &bo.product(ao), 1))?;
    let own = real_part(&be.product(ae), &bo.product(ao), -1);
    let own = at(&own.product(&w).product(&w).product(&w).product(&w))?;
    let inverse = inverse(&square, peaks).ok_or_else(none)?;
    // Times h^2, of x by its own spring and by that of the absorber.
    let over = |part: &AtPeaks| -> AtPeaks {
        product(part, &inverse, peaks).map(|part| part.product(&lowest.height))
    };
    let [main_free, main_slope] = over(&main);
    let [own_free, own_slope] = over(&product(&product(&own, &inverse, peaks), &inverse, peaks));
    // mu b3/alpha3
    let ratio_of_springs = main_slope.quotient(&own_slope).ok_or_else(none)?;
    let ratio_of_springs = ratio_of_springs.product(&minus_one(&main_free));
    let change = main_free.sum(&ratio_of_springs.product(&own_free));
    let mass = Polynomial::symbol(names.mu);
    let mass = RationalFunction::from_polynomial(&mass, names.mu).ok_or_else(none)?;
    let spring = ratio_of_springs.quotient(&main_free.constant(mass)).ok_or_else(none)?;
    let written = |value: &QuadraticSurd| value.to_expr(names.mu);
    let expr = |name: &str| Expr::symbol(name);
    let [h, c] = ["h", "c"].map(expr);
    let loss = [expr("alpha3"), expr("F").integer_power(2)?, h.integer_power(2)?, c.clone()];
    let loss = Expr::number(ratio(3, 4)) * Expr::product(loss.to_vec());
    let height = h * (Expr::one() - loss);
    let formula = |name: &'static str, symbol: &str, formula: Expr| AbsorberFormula {
        name,
        symbol: Symbol::new(symbol),
        formula,
    };
    let formulas = vec![
        formula("tuning", "f", lowest.p.sqrt_expr(names.mu)?),
        formula("damping", "zeta", lowest.damping.sqrt_expr(names.mu)?),
        formula("cubic", "b3", written(&spring)? * expr("alpha3")),
        formula("lower_height", "H1", height.clone()),
        formula("upper_height", "H2", height),
    ];
    let square = expr("g").integer_power(2)?;
    let [a, b] = peaks;
    let places = square.integer_power(2)? + written(a)? * square + written(b)?;
    Ok(AbsorberLaws {
        kind: AbsorberKind::Nonlinear,
        equations: equations.equations,
        meanings: vec![
            (names.mu, "mass of the absorber over the main mass"),
            (alpha3, "cubic coefficient of the spring of the main mass"),
            (force, "amplitude of the force"),
            (names.f, "natural frequency of the absorber alone over that of the main mass alone"),
            (names.zeta, "damping ratio of the absorber alone"),
            (b3, "cubic coefficient of the spring of the absorber, over its mass"),
            (names.g, "frequency of the force over that of the main mass alone"),
            (Symbol::new("h"), "amplitude of x over F at both peaks, F small"),
            (Symbol::new("P"), "real part of X at a peak, the complex amplitude of x over F there"),
            (
                Symbol::new("Q"),
                "real part of |Z|^2 Z^2/(h^2 X) at a peak, Z the complex amplitude of x - y over F",
            ),
            (Symbol::new("H1"), "amplitude of x over F at the lower peak"),
            (Symbol::new("H2"), "amplitude of x over F at the upper peak"),
        ],
        definitions: vec![
            Definition { symbol: Symbol::new("h"), meaning: lowest.height.sqrt_expr(names.mu)? },
            Definition { symbol: Symbol::new("c"), meaning: written(&change)? },
        ],
        relations: vec![
            AbsorberRelation {
                left: Expr::zero(),
                right: places,
                words: "the two peaks of the linear absorber",
            },
            AbsorberRelation {
                left: c * expr("alpha3"),
                right: expr("alpha3") * expr("P") + expr("mu") * expr("b3") * expr("Q"),
                words: "the loss of height, equal at both peaks",
            },
        ],
        designs: vec![AbsorberDesign {
            name: "similar-springs",
            words: "the linear absorber with the lowest peak, and a cubic spring that keeps its two peaks equally high",
            formulas,
            refined_by: None,
        }],
        validity: "first order in alpha3 F^2, one harmonic; no damping of the main mass; steady motions of larger forces may lie on detached branches",
    })
}

/// The equations without cubic springs under the force 1.
fn linear(equations: &CoupledEquations) -> Result<CoupledEquations, AbsorberError> {
    let mut linear = equations.clone();
    let numbers = [("alpha3", 0), ("b3", 0), ("F", 1)];
    let numbers = numbers.map(|(name, number)| (Symbol::new(name), Expr::from(number))).into();
    for (left, right) in &mut linear.equations {
        *left = left.substitute_all(&numbers)?;
        *right = right.substitute_all(&numbers)?;
    }
    Ok(linear)
}

fn minus_one(field: &QuadraticSurd) -> QuadraticSurd {
    field.constant(RationalFunction::number(-Rational::one()))
}

/// The product, where `w^2 = -a w - b`.
fn product(left: &AtPeaks, right: &AtPeaks, [a, b]: &[QuadraticSurd; 2]) -> AtPeaks {
    let square = left[1].product(&right[1]).product(&minus_one(a));
    [
        left[0].product(&right[0]).sum(&square.product(b)),
        left[0].product(&right[1]).sum(&left[1].product(&right[0])).sum(&square.product(a)),
    ]
}

/// One over a number, by its value at the other root; `None` of zero.
fn inverse([free, slope]: &AtPeaks, peaks: &[QuadraticSurd; 2]) -> Option<AtPeaks> {
    let minus_slope = slope.product(&minus_one(slope));
    let other = [free.sum(&minus_slope.product(&peaks[0])), minus_slope];
    let [norm, _] = product(&[free.clone(), slope.clone()], &other, peaks);
    let [free, slope] = other;
    Some([free.quotient(&norm)?, slope.quotient(&norm)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The published law is close where the absorber is light, and the same to first order in mu.
    #[test]
    fn the_spring_is_near_the_published_one() {
        let laws = derive().expect("closed forms");
        let cubic = |mu: f64| {
            let at = format!("mu = {mu}, alpha3 = 1, F = 1/100").parse().expect("values");
            laws.named_value("similar-springs", "cubic", &at).expect("a number")
        };
        let published = |mu: f64| 2.0 * mu / (1.0 + 4.0 * mu);
        for (mu, relative) in
            [(0.01, 1.0071), (0.05, 1.0252), (0.1, 1.0299), (0.2, 1.0026), (0.5, 0.8264)]
        {
            let own = cubic(mu) / published(mu);
            assert!((own - relative).abs() < 1e-4, "{mu}: {own}");
        }
    }
}

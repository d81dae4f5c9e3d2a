//! Relations between the amplitudes of steady motions, with the phases eliminated.
//!
//! ```text
//! a_j' = P + c1 cos(alpha) + s1 sin(alpha) = 0,   a_j phi_j' = Q + c2 cos(alpha) + s2 sin(alpha) = 0
//! cos(alpha) = (s1 Q - s2 P)/D,  sin(alpha) = (c2 P - c1 Q)/D,  D = c1 s2 - c2 s1,   cos^2 + sin^2 = 1
//! ```
//!
//! A mode whose equations have one combination alpha of phases that is not known yet gives a relation,
//! and its cosine and sine stand in the equations of the others. Saturation is such a relation: it
//! has a single amplitude in it, and that of another mode. Relations are sought with all modes moving
//! that are locked to the drive, and with each of them at rest that may be so.

use std::collections::BTreeMap;

use num_integer::Integer as _;
use num_traits::{One, Zero};

use super::answer::KEPT_DIGITS;
use super::{PhaseWaves, SlowMotion};
use crate::decimal::rounded_fraction;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::Integer;
use crate::exact::{Polynomial, Rational};
use crate::expr::Expr;
use crate::symbol::Symbol;

/// A relation of steady motions.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyRelation {
    /// The indices of the modes that are at rest; the others move.
    pub at_rest: Vec<usize>,
    /// The index of the mode whose phase was eliminated.
    pub mode: usize,
    /// The polynomial that vanishes.
    pub relation: Polynomial,
    /// The amplitude that the relation fixes, and its square, where it has a single one.
    pub solved: Option<(Symbol, Expr)>,
}

/// A quotient of polynomials, the second a single term.
type Angle = [Polynomial; 2];

impl SlowMotion {
    /// The relations of steady motions whose phases are all fixed by drives; none where a phase is
    /// open, or where equations have several new combinations of phases at once.
    pub fn steady_relations(&self) -> Vec<SteadyRelation> {
        let count = self.amplitudes.len();
        if !self.is_driven() {
            return vec![];
        }
        let free: Vec<usize> = (0..count).filter(|mode| !self.locked[*mode]).collect();
        let resting = (0..count)
            .filter(|mode| self.locked[*mode])
            .map(|mode| free.iter().copied().chain([mode]).collect());
        let mut found = Vec::new();
        for at_rest in std::iter::once(free.clone()).chain(resting) {
            if at_rest.len() < count && self.may_rest(&at_rest) {
                let own = self.relations(&at_rest);
                // A mode without a relation may be one that cannot move.
                if own.len() + at_rest.len() == count {
                    found.extend(own);
                }
            }
        }
        found
    }

    /// Whether these modes stay at rest.
    fn may_rest(&self, at_rest: &[usize]) -> bool {
        at_rest.iter().all(|mode| {
            let rate = &self.rates[*mode];
            let waves = rate.amplitude.values().chain(rate.phase.values()).flatten();
            waves.flat_map(Polynomial::terms).all(|(monomial, _)| {
                at_rest.iter().any(|mode| monomial.exponent(self.amplitudes[*mode]) > 0)
            })
        })
    }

    /// The relations with these modes at rest.
    fn relations(&self, at_rest: &[usize]) -> Vec<SteadyRelation> {
        let still = |polynomial: &Polynomial| {
            let mut kept = Polynomial::zero();
            for (monomial, number) in polynomial.terms() {
                if at_rest.iter().all(|mode| monomial.exponent(self.amplitudes[*mode]) == 0) {
                    kept.add_term(monomial.clone(), number.clone());
                }
            }
            kept
        };
        let waves = |waves: &PhaseWaves| -> PhaseWaves {
            waves
                .iter()
                .map(|(turns, parts)| (turns.clone(), parts.each_ref().map(still)))
                .filter(|(_, parts): &(Vec<i32>, [Polynomial; 2])| !parts.iter().all(Zero::is_zero))
                .collect()
        };
        let mut open: Vec<(usize, [PhaseWaves; 2])> = (0..self.rates.len())
            .filter(|mode| !at_rest.contains(mode))
            .map(|mode| {
                (mode, [waves(&self.rates[mode].amplitude), waves(&self.rates[mode].phase)])
            })
            .collect();
        let mut known: BTreeMap<Vec<i32>, [Angle; 2]> = BTreeMap::new();
        let mut found = Vec::new();
        loop {
            let next = open.iter().position(|(_, rates)| new_angles(rates, &known).len() == 1);
            let Some(next) = next else { return found };
            let (mode, rates) = open.remove(next);
            let Some(alpha) = new_angles(&rates, &known).pop() else { return found };
            let Some((relation, angle)) = eliminated(&rates, &alpha, &known) else {
                return found;
            };
            known.insert(alpha, angle);
            let relation = self.without_common_powers(&relation);
            let solved = self.single_square(&relation);
            found.push(SteadyRelation { at_rest: at_rest.to_vec(), mode, relation, solved });
        }
    }

    /// A polynomial divided by the powers that all its terms have, negative ones too, its
    /// coefficients whole numbers without a common divisor; rounded ones are divided by the first of them.
    fn without_common_powers(&self, polynomial: &Polynomial) -> Polynomial {
        let numbers = || polynomial.terms().map(|(_, number)| number);
        let below = numbers().fold(Integer::one(), |common, number| common.lcm(number.denom()));
        let above = numbers().fold(Integer::zero(), |common, number| common.gcd(number.numer()));
        let first = numbers().next().filter(|_| self.rounded).cloned();
        let mut reduced = match (first, above.is_zero()) {
            (Some(first), _) => {
                polynomial.map(|number| rounded_fraction(&(number / &first), KEPT_DIGITS))
            }
            (None, true) => polynomial.clone(),
            (None, false) => {
                polynomial.map(|number| number * Rational::new(below.clone(), above.clone()))
            }
        };
        for name in polynomial.symbols() {
            if let Some((lowest, _)) = reduced.exponent_range(name) {
                reduced = reduced.times_monomial(&Monomial::power_of(name, -lowest));
            }
        }
        reduced
    }

    /// The square of an amplitude, where a relation has that alone.
    fn single_square(&self, relation: &Polynomial) -> Option<(Symbol, Expr)> {
        let mut own = self.amplitudes.iter().filter(|name| relation.symbols().contains(name));
        let (name, None) = (own.next()?, own.next()) else { return None };
        let (mut constant, mut slope) = (Polynomial::zero(), Polynomial::zero());
        for (monomial, number) in relation.terms() {
            let rest = monomial.without(*name);
            match monomial.exponent(*name) {
                0 => constant.add_term(rest, number.clone()),
                2 => slope.add_term(rest, number.clone()),
                _ => return None,
            }
        }
        constant.negate();
        let square = match slope.power(-1) {
            Some(inverse) => Expr::from(&constant.product(&inverse)),
            None => Expr::divide(&Expr::from(&constant), &Expr::from(&slope)).ok()?,
        };
        Some((*name, square))
    }
}

/// The combinations of phases in the rates of a mode that are not known.
fn new_angles(rates: &[PhaseWaves; 2], known: &BTreeMap<Vec<i32>, [Angle; 2]>) -> Vec<Vec<i32>> {
    let mut found: Vec<Vec<i32>> = rates
        .iter()
        .flat_map(BTreeMap::keys)
        .filter(|turns| turns.iter().any(|m| *m != 0) && !known.contains_key(*turns))
        .cloned()
        .collect();
    found.sort();
    found.dedup();
    found
}

/// The relation that is left when the cosine and the sine of a combination are eliminated, and these.
fn eliminated(
    [amplitude, phase]: &[PhaseWaves; 2],
    alpha: &[i32],
    known: &BTreeMap<Vec<i32>, [Angle; 2]>,
) -> Option<(Polynomial, [Angle; 2])> {
    let one = || Polynomial::constant(Rational::one());
    // The known part of each rate over a common divisor.
    let still = |waves: &PhaseWaves| -> Option<Angle> {
        let mut sum: Angle = [Polynomial::zero(), one()];
        for (turns, [cosine, sine]) in waves.iter().filter(|(turns, _)| *turns != alpha) {
            if turns.iter().all(|m| *m == 0) {
                sum = added(&sum, &[cosine.clone(), one()]);
                continue;
            }
            let [c, s] = known.get(turns)?;
            for ([above, below], factor) in [(c, cosine), (s, sine)] {
                if !factor.is_zero() {
                    sum = added(&sum, &[above.product(factor), below.clone()]);
                }
            }
        }
        Some(sum)
    };
    let zero = [Polynomial::zero(), Polynomial::zero()];
    let [c1, s1] = amplitude.get(alpha).unwrap_or(&zero);
    let [c2, s2] = phase.get(alpha).unwrap_or(&zero);
    let (p, q) = (still(amplitude)?, still(phase)?);
    let less = |left: Polynomial, right: &Polynomial| {
        let mut right = right.clone();
        right.negate();
        left + right
    };
    let determinant = less(c1.product(s2), &c2.product(s1));
    determinant.single_term()?;
    let times = |factor: &Polynomial, value: &Angle| [value[0].product(factor), value[1].clone()];
    let minus = |mut value: Angle| {
        value[0].negate();
        value
    };
    let cosine = added(&times(s1, &q), &minus(times(s2, &p)));
    let sine = added(&times(c2, &p), &minus(times(c1, &q)));
    let over = |value: Angle| [value[0].clone(), value[1].product(&determinant)];
    let (cosine, sine) = (over(cosine), over(sine));
    let square = |value: &Angle| [value[0].product(&value[0]), value[1].product(&value[1])];
    let [above, below] = added(&square(&cosine), &square(&sine));
    Some((less(above, &below), [cosine, sine]))
}

/// The sum of two quotients, over one divisor where they have the same.
fn added([a, b]: &Angle, [c, d]: &Angle) -> Angle {
    if b == d {
        return [a.clone() + c.clone(), b.clone()];
    }
    let inverse = |divisor: &Polynomial| divisor.power(-1);
    match (inverse(b), inverse(d)) {
        (Some(first), Some(second)) => {
            [a.product(&first) + c.product(&second), Polynomial::constant(Rational::one())]
        }
        _ => [a.product(d) + c.product(b), b.product(d)],
    }
}

//! Steady motions that only the truncation of slow equations makes: spurious ones.
//!
//! ```text
//! G(z, s) = L(z) + s C_1(z) + s^2 C_2(z) + ...      z = (u, v);  of each part of the slow equations (what drains, what turns, each wave
//!                                                   of the phase) L has the order that leads, C_k what comes k orders later
//! G(z, 1) = 0 is what the slow equations say; as s goes to zero a motion of the equation tends to one of L(z) = 0
//! ```
//!
//! A steady motion is followed in s from one to zero, through folds, by pseudo-arclength. It is a motion of the equation if it comes to
//! s = 0, spurious if it grows beyond all bounds on the way: what balances there is the last order against those before it, at an
//! amplitude at which the series no longer converges. Where two steady motions meet at an s in between, the leading order has neither:
//! beside a jump, whose place moves with the order, or at rest, from which a motion is born at another place, or because the truncation
//! makes both. Then the sizes decide: both are spurious if in some part what follows with a higher power of the amplitude is no smaller
//! than what leads.
//!
//! Reference: E. L. Allgower, K. Georg, *Introduction to Numerical Continuation Methods*, SIAM 2003, chapters 2 and 11 (homotopies).

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};

use super::Solution;
use super::response::Plane;
use crate::exact::Polynomial;
use crate::symbol::Symbol;

/// `u`, `v` in parts of the radius at the start, and `s`.
type Place = Vector3<f64>;

/// A polynomial in `u` and `v` with numbers.
struct Numeric(Vec<(f64, [i32; 2])>);

impl Numeric {
    fn new(
        solution: &Solution,
        polynomial: &Polynomial,
        [u, v]: [Symbol; 2],
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Option<Self> {
        let mut coefficients: BTreeMap<[i32; 2], Polynomial> = BTreeMap::new();
        for (monomial, number) in polynomial.terms() {
            let exponents = [u, v].map(|name| monomial.exponent(name));
            let rest = monomial.without(u).without(v);
            let coefficient = coefficients.entry(exponents).or_insert_with(num_traits::Zero::zero);
            coefficient.add_term(rest, number.clone());
        }
        let value = |(exponents, coefficient): (&[i32; 2], &Polynomial)| {
            Some((solution.evaluate(coefficient, value_of).ok()?, *exponents))
        };
        coefficients.iter().map(value).collect::<Option<_>>().map(Self)
    }

    /// Its value, and its slopes by both.
    fn at(&self, [u, v]: [f64; 2]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (factor, [i, j]) in &self.0 {
            sum[0] += factor * u.powi(*i) * v.powi(*j);
            if *i > 0 {
                sum[1] += factor * f64::from(*i) * u.powi(i - 1) * v.powi(*j);
            }
            if *j > 0 {
                sum[2] += factor * f64::from(*j) * u.powi(*i) * v.powi(j - 1);
            }
        }
        sum
    }

    /// The sum of the sizes of its terms above a degree, on the circle of this radius.
    fn size(&self, radius: f64, above: i32) -> f64 {
        let across = radius * std::f64::consts::FRAC_1_SQRT_2;
        let terms = self.0.iter().filter(|(_, [i, j])| i + j > above);
        terms.map(|(factor, [i, j])| factor.abs() * across.powi(i + j)).sum()
    }

    /// The lowest degree of its terms.
    fn lowest_degree(&self) -> Option<i32> {
        let terms = self.0.iter().filter(|(factor, _)| *factor != 0.0);
        terms.map(|(_, [i, j])| i + j).min()
    }
}

/// Where a steady motion leads as `s` goes to zero.
enum Way {
    /// To a motion of the leading order.
    Tends,
    /// Beyond all bounds.
    Escapes,
    /// Nowhere: it meets another one.
    Meets,
}

/// Slow equations by their orders, with numbers.
pub(super) struct Orders(Vec<Vec<[Numeric; 2]>>);

impl Orders {
    /// `None` where a value is missing.
    pub(super) fn new(solution: &Solution, plane: &Plane, value_of: &dyn Fn(Symbol) -> Option<f64>) -> Option<Self> {
        let defined = solution.defined_values(value_of).ok()?;
        let value_of = |name: Symbol| {
            let own = defined.iter().find(|(known, _)| *known == name);
            own.map(|(_, value)| *value).or_else(|| value_of(name))
        };
        let numeric = |rate: &Polynomial| Numeric::new(solution, rate, plane.coordinates, &value_of);
        let mut parts = Vec::new();
        for part in &plane.parts {
            let mut orders: Vec<[Numeric; 2]> = Vec::new();
            for [u, v] in part {
                let rates = [numeric(u)?, numeric(v)?];
                // What is nothing with these numbers does not lead.
                if !orders.is_empty() || rates.iter().any(|rate| rate.lowest_degree().is_some()) {
                    orders.push(rates);
                }
            }
            parts.push(orders);
        }
        Some(Self(parts))
    }

    /// Whether a steady motion is one of the truncated equations alone.
    pub(super) fn is_spurious(&self, place: [f64; 2]) -> bool {
        if self.0.iter().all(|part| part.len() < 2) {
            return false;
        }
        match self.way(place) {
            Way::Tends => false,
            Way::Escapes => true,
            Way::Meets => self.diverges(place[0].hypot(place[1])),
        }
    }

    /// Whether in some part what follows is no smaller than what leads. What follows with no higher a power of the amplitude is there at
    /// every amplitude, such as a shift of the frequency: it does not count.
    fn diverges(&self, radius: f64) -> bool {
        let size = |rates: &[Numeric; 2], above: i32| rates.iter().map(|rate| rate.size(radius, above)).sum::<f64>();
        self.0.iter().any(|part| {
            let Some((leads, follow)) = part.split_first() else {
                return false;
            };
            let lowest = leads.iter().filter_map(Numeric::lowest_degree).min().unwrap_or(0);
            follow.iter().map(|rates| size(rates, lowest)).sum::<f64>() >= size(leads, -1)
        })
    }

    /// `G`, and its slopes by `u`, `v` and `s`.
    fn at(&self, place: [f64; 2], s: f64) -> [[f64; 4]; 2] {
        let mut sum = [[0.0; 4]; 2];
        for part in &self.0 {
            let (mut power, mut slope) = (1.0, 0.0);
            for (k, rates) in part.iter().enumerate() {
                for (sum, rate) in sum.iter_mut().zip(rates) {
                    let [value, by_u, by_v] = rate.at(place);
                    let added = [power * value, power * by_u, power * by_v, slope * value];
                    for (sum, added) in sum.iter_mut().zip(added) {
                        *sum += added;
                    }
                }
                slope = (k + 1) as f64 * power;
                power *= s;
            }
        }
        sum
    }

    /// The equations and their slopes, with a last row.
    fn bordered(&self, at: &Place, radius: f64, row: &Place) -> (Matrix3<f64>, [f64; 2]) {
        let [one, other] = self.at([radius * at[0], radius * at[1]], at[2]);
        let scaled = |[_, by_u, by_v, by_s]: [f64; 4]| [radius * by_u, radius * by_v, by_s];
        let [[a, b, c], [d, e, f]] = [one, other].map(scaled);
        let matrix = Matrix3::new(a, b, c, d, e, f, row[0], row[1], row[2]);
        (matrix, [one[0], other[0]])
    }

    /// The tangent at a steady motion that goes on as another one does.
    fn tangent(&self, at: &Place, radius: f64, before: &Place) -> Option<Place> {
        let (matrix, _) = self.bordered(at, radius, before);
        let found = matrix.lu().solve(&Vector3::new(0.0, 0.0, 1.0))?;
        let length = found.norm();
        (length > 0.0 && length.is_finite()).then(|| found / length)
    }

    /// Newton's steps at right angles to a direction.
    fn corrected(&self, guess: &Place, radius: f64, direction: &Place) -> Option<Place> {
        const MOST: usize = 8;
        const SETTLED: f64 = 1e-10;
        let mut at = *guess;
        for _ in 0..MOST {
            let (matrix, [one, other]) = self.bordered(&at, radius, direction);
            let right = Vector3::new(-one, -other, -direction.dot(&(at - guess)));
            let step = matrix.lu().solve(&right)?;
            at += step;
            if step.norm() <= SETTLED {
                return Some(at);
            }
        }
        None
    }

    fn way(&self, place: [f64; 2]) -> Way {
        /// In parts of the radius at the start, and of all of `s`.
        const FIRST: f64 = 0.02;
        const LONGEST: f64 = 0.1;
        const SHORTEST: f64 = 1e-6;
        const MOST: usize = 1000;
        /// How much larger than at the start it may become.
        const BOUND: f64 = 10.0;
        /// Cosine of the angle between tangents.
        const SHARPEST: f64 = 0.9;
        let radius = place[0].hypot(place[1]);
        let mut at = Place::new(place[0] / radius, place[1] / radius, 1.0);
        let Some(mut tangent) = self.tangent(&at, radius, &Place::new(0.0, 0.0, -1.0)) else {
            return Way::Meets;
        };
        let mut step = FIRST;
        for _ in 0..MOST {
            let found = self.corrected(&(at + tangent * step), radius, &tangent);
            let next = found.and_then(|found| Some((found, self.tangent(&found, radius, &tangent)?)));
            let Some((found, along)) = next.filter(|(_, along)| along.dot(&tangent) > SHARPEST) else {
                step /= 2.0;
                if step < SHORTEST {
                    return Way::Meets;
                }
                continue;
            };
            (at, tangent) = (found, along);
            if at[2] <= 0.0 {
                return Way::Tends;
            }
            if at[0].hypot(at[1]) > BOUND {
                return Way::Escapes;
            }
            if at[2] >= 1.0 {
                return Way::Meets;
            }
            step = (1.5 * step).min(LONGEST);
        }
        Way::Meets
    }
}

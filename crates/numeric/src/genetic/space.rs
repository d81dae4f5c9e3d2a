//! The box that is searched, and the evaluation of its points.

use rand::{Rng, RngExt};

use super::SearchError;

/// A box: a lower and an upper bound of every variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Space(Vec<[f64; 2]>);

impl Space {
    /// The box between these bounds, finite and the lower one first.
    ///
    /// # Errors
    /// [`SearchError`] if there is no variable, or one without a finite range.
    pub fn new(bounds: Vec<[f64; 2]>) -> Result<Self, SearchError> {
        if bounds.is_empty() {
            return Err(SearchError::Empty);
        }
        for (index, &[lower, upper]) in bounds.iter().enumerate() {
            let range = upper - lower;
            if !(range > 0.0 && range.is_finite()) {
                let number = index + 1;
                return Err(SearchError::Inverted { number, lower, upper });
            }
        }
        Ok(Self(bounds))
    }

    /// Lower and upper bound of every variable.
    pub fn bounds(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// Whether a point lies in the box.
    pub fn contains(&self, point: &[f64]) -> bool {
        let inside = |(x, [lower, upper]): (&f64, &[f64; 2])| (*lower..=*upper).contains(x);
        point.len() == self.0.len() && point.iter().zip(&self.0).all(inside)
    }

    /// Returns the point at these fractions of the ranges, 0 being the lower and 1 the upper bound;
    /// it never lies outside the box.
    pub fn point_at(&self, parts: &[f64]) -> Vec<f64> {
        let place = |(part, [lower, upper]): (&f64, &[f64; 2])| {
            (lower + part * (upper - lower)).clamp(*lower, *upper)
        };
        parts.iter().zip(&self.0).map(place).collect()
    }

    /// A point drawn evenly from the box.
    pub fn draw(&self, generator: &mut impl Rng) -> Vec<f64> {
        let parts: Vec<f64> = self.0.iter().map(|_| generator.random()).collect();
        self.point_at(&parts)
    }
}

/// Objectives and constraints of a point.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Evaluation {
    /// Objectives to be minimised; infinite if they have no value.
    pub objectives: Vec<f64>,
    /// Equalities, to be zero, scaled so that 1 is a large violation.
    pub equalities: Vec<f64>,
    /// Inequalities, to be at most zero, scaled likewise.
    pub inequalities: Vec<f64>,
}

impl Evaluation {
    /// The evaluation of a point with one objective and no constraints.
    pub fn unconstrained(value: f64) -> Self {
        Self { objectives: vec![value], ..Self::default() }
    }

    /// The first objective; infinite if it is not a number.
    pub fn value(&self) -> f64 {
        let value = self.objectives.first().copied().unwrap_or(f64::INFINITY);
        if value.is_nan() { f64::INFINITY } else { value }
    }

    /// Returns the sum of the violations of all constraints; an equality counts by its excess over
    /// the tolerance.
    pub fn violation(&self, tolerance: f64) -> f64 {
        let equalities = self.equalities.iter().map(|value| (value.abs() - tolerance).max(0.0));
        let inequalities = self.inequalities.iter().map(|value| value.max(0.0));
        let sum = equalities.chain(inequalities).fold(0.0, |sum, part| sum + part);
        if sum.is_nan() { f64::INFINITY } else { sum }
    }

    /// Whether the objectives are finite and no constraint is violated.
    pub fn is_feasible(&self, tolerance: f64) -> bool {
        self.violation(tolerance) == 0.0 && self.objectives.iter().all(|value| value.is_finite())
    }
}

//! The score of a point that violates a constraint: a number for every individual, the smaller the
//! better.
//!
//! - Death penalty: the score is infinite.
//! - Feasible first (K. Deb, *Comput. Methods Appl. Mech. Eng.* 186 (2000) 311): the worst value of
//!   the points that violate no constraint, plus the sum of the violations.
//! - Augmented Lagrangian (R. T. Rockafellar, *Math. Program.* 5 (1973) 354), f under c_e = 0 and c
//!   <= 0:
//!
//! ```text
//! score = f + sum_e (l_e c_e + (rho/2) c_e^2) + (1/(2 rho)) sum (max(0, l + rho c)^2 - l^2)
//! after every subproblem, of a fixed number of generations, at its best point:
//!   violated no more than the tolerance, or a quarter of before:  l_e <- l_e + rho c_e,  l <- max(0, l + rho c)
//!   else  rho <- rho times the penalty factor
//! ```
//!
//! rho begins as the initial penalty, l at zero. MATLAB's `ga` puts inequalities into a logarithm
//! instead; its initial penalty 10 and factor 100 are these rho and its factor. Without nonlinear
//! constraints neither has an effect.

use super::space::Evaluation;

/// The treatment of points that violate a constraint.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Penalty {
    /// Points that violate a constraint have an infinite score.
    #[default]
    Death,
    /// Points that violate a constraint rank behind all that violate none.
    FeasibleFirst,
    /// Points that violate a constraint pay a penalty.
    AugmentedLagrangian {
        /// The initial rho.
        initial: f64,
        /// The factor by which rho grows while the violation does not fall fast enough.
        factor: f64,
    },
}

/// The largest rho: beyond it the objective has no digits left.
const LARGEST_WEIGHT: f64 = 1e10;

/// The multipliers of an augmented Lagrangian.
#[derive(Debug, Clone, PartialEq)]
pub struct Multipliers {
    /// The weight rho of the squared violations.
    pub weight: f64,
    /// Multipliers of the equalities.
    pub equalities: Vec<f64>,
    /// Multipliers of the inequalities, none negative.
    pub inequalities: Vec<f64>,
    /// Violation of the best point of the last subproblem; infinite before the first.
    violation: f64,
}

impl Multipliers {
    /// Multipliers of zero, one for each constraint of `like`, with rho = `initial`.
    pub fn new(initial: f64, like: &Evaluation) -> Self {
        Self {
            weight: initial,
            equalities: vec![0.0; like.equalities.len()],
            inequalities: vec![0.0; like.inequalities.len()],
            violation: f64::INFINITY,
        }
    }

    /// The augmented Lagrangian at a point.
    pub fn lagrangian(&self, of: &Evaluation) -> f64 {
        let rho = self.weight;
        let equalities = self.equalities.iter().zip(&of.equalities);
        let equalities: f64 = equalities.map(|(l, c)| l * c + 0.5 * rho * c * c).sum();
        let inequalities = self.inequalities.iter().zip(&of.inequalities);
        let inequalities: f64 =
            inequalities.map(|(l, c)| ((l + rho * c).max(0.0).powi(2) - l * l) / (2.0 * rho)).sum();
        let score = of.value() + equalities + inequalities;
        if score.is_nan() { f64::INFINITY } else { score }
    }

    /// Updates the multipliers, or rho, after a subproblem whose best point is `best`.
    pub fn update(&mut self, best: &Evaluation, factor: f64, tolerance: f64) {
        let violation = best.violation(tolerance);
        if violation <= (0.25 * self.violation).max(tolerance) {
            let rho = self.weight;
            for (l, c) in self.equalities.iter_mut().zip(&best.equalities) {
                *l += rho * c;
            }
            for (l, c) in self.inequalities.iter_mut().zip(&best.inequalities) {
                *l = (*l + rho * c).max(0.0);
            }
        } else {
            self.weight = (factor * self.weight).min(LARGEST_WEIGHT);
        }
        self.violation = violation;
    }
}

/// Returns the score of every individual, the smaller the better.
pub fn scores(
    population: &[&Evaluation],
    penalty: Penalty,
    multipliers: Option<&Multipliers>,
    tolerance: f64,
) -> Vec<f64> {
    let death = |of: &&Evaluation| match of.violation(tolerance) == 0.0 {
        true => of.value(),
        false => f64::INFINITY,
    };
    match (penalty, multipliers) {
        (Penalty::AugmentedLagrangian { .. }, Some(multipliers)) => {
            population.iter().map(|of| multipliers.lagrangian(of)).collect()
        }
        (Penalty::FeasibleFirst, _) => {
            let feasible = population.iter().map(death).filter(|value| value.is_finite());
            let worst = feasible.fold(f64::NEG_INFINITY, f64::max);
            let worst = if worst.is_finite() { worst } else { 0.0 };
            let score = |of: &&Evaluation| match of.violation(tolerance) {
                0.0 => of.value(),
                violation => worst + violation,
            };
            population.iter().map(score).collect()
        }
        _ => population.iter().map(death).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(value: f64, equality: f64, inequality: f64) -> Evaluation {
        Evaluation {
            objectives: vec![value],
            equalities: vec![equality],
            inequalities: vec![inequality],
        }
    }

    #[test]
    fn death_is_final_and_the_feasible_come_first() {
        let population =
            [at(5.0, 0.0, -1.0), at(1.0, 0.0, 0.5), at(9.0, 0.0, 0.0), at(2.0, 0.3, 0.0)];
        let population: Vec<&Evaluation> = population.iter().collect();
        assert_eq!(
            scores(&population, Penalty::Death, None, 0.01),
            [5.0, f64::INFINITY, 9.0, f64::INFINITY]
        );
        let found = scores(&population, Penalty::FeasibleFirst, None, 0.01);
        assert_eq!(found[..3], [5.0, 9.5, 9.0]);
        assert!((found[3] - 9.29).abs() < 1e-12);
    }

    #[test]
    fn a_constraint_that_holds_costs_nothing() {
        let multipliers = Multipliers::new(10.0, &at(0.0, 0.0, 0.0));
        assert_eq!(multipliers.lagrangian(&at(5.0, 0.0, -1.0)), 5.0);
        assert!((multipliers.lagrangian(&at(5.0, 0.1, 0.2)) - 5.25).abs() < 1e-12);
    }

    /// min x^2 + y^2 under x + y = 1 and x >= 0.75: x = 0.75, and l of the equality -1/2, of the
    /// inequality 1.
    #[test]
    fn the_multipliers_become_those_of_lagrange() {
        let mut multipliers = Multipliers::new(10.0, &at(0.0, 0.0, 0.0));
        let mut last = [0.0; 2];
        for _ in 0..30 {
            let evaluate = |[x, y]: [f64; 2]| at(x * x + y * y, x + y - 1.0, 0.75 - x);
            // By hand: steepest descent of the Lagrangian, which is convex.
            let mut point = last;
            for _ in 0..20_000 {
                let (l, rho, of) = (&multipliers, multipliers.weight, evaluate(point));
                let common = l.equalities[0] + rho * of.equalities[0];
                let wall = (l.inequalities[0] + rho * of.inequalities[0]).max(0.0);
                let rate = 0.3 / (1.0 + rho);
                point[0] -= rate * (2.0 * point[0] + common - wall);
                point[1] -= rate * (2.0 * point[1] + common);
            }
            multipliers.update(&evaluate(point), 2.0, 1e-6);
            last = point;
        }
        assert!((last[0] - 0.75).abs() < 1e-6 && (last[1] - 0.25).abs() < 1e-6, "{last:?}");
        assert!((multipliers.equalities[0] + 0.5).abs() < 1e-3, "{multipliers:?}");
        assert!((multipliers.inequalities[0] - 1.0).abs() < 1e-3, "{multipliers:?}");
    }

    #[test]
    fn the_weight_grows_by_the_factor_where_the_constraint_stays_broken() {
        let mut multipliers = Multipliers::new(10.0, &at(0.0, 0.0, 0.0));
        for weight in [10.0, 1000.0, 1e5] {
            multipliers.update(&at(1.0, 0.5, 0.0), 100.0, 1e-3);
            assert_eq!(multipliers.weight, weight);
        }
    }
}

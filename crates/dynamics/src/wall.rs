//! Rigid walls: one-sided constraints with a coefficient of restitution, in any equations of motion.
//!
//! ```text
//! g(q, t) >= 0                                     the gap
//! g' = n.q' + dg/dt,  n = dg/dq                    its rate
//! q' -> q' - (1 + e) M^-1 n g'/(n.M^-1 n)          an impact: g' -> -e g', momentum kept along the wall
//! q'' -> q'' + M^-1 n lambda,  lambda = -g''/(n.M^-1 n) >= 0      rest on the wall, until lambda = 0
//! ```
//!
//! (F. Pfeiffer, C. Glocker, *Multibody Dynamics with Unilateral Contacts*, Wiley 1996, chapters 5
//! and 8; B. Brogliato, *Nonsmooth Mechanics*, 3rd ed., Springer 2016, chapter 4.)

use std::collections::BTreeMap;

use thiserror::Error;

use crate::expr::{EvaluationError, Expr, ExprError, ParseError, parse_inequality};
use crate::mechanics::{MechanicsError, linear};
use crate::symbol::Symbol;

/// A rigid wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    /// The gap g in coordinates, time and parameters: positive in flight, zero at the wall.
    pub gap: Expr,
    /// The coefficient of restitution e in parameters: the speed after an impact over that before.
    pub restitution: Expr,
}

/// The reason why a text is not a wall, or a wall has no impacts.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum WallError {
    /// A text has a syntax error.
    #[error(transparent)]
    Parse(#[from] ParseError),
    /// The coefficient of restitution has no value.
    #[error("the coefficient of restitution `{0}`: {1}")]
    Undefined(Expr, EvaluationError),
    /// The coefficient of restitution is out of range.
    #[error(
        "the coefficient of restitution is {0}, but an impact takes energy or keeps it: it lies between 0 (all of it goes) and 1"
    )]
    Restitution(f64),
    /// No coordinate occurs in a gap.
    #[error("the wall `{gap} = 0` contains no coordinate: it needs one of {coordinates}")]
    NoCoordinate {
        /// The gap.
        gap: Expr,
        /// The names of the coordinates.
        coordinates: String,
    },
    /// A velocity occurs in a gap.
    #[error("the wall `{0} = 0` contains the velocity `{1}`: a wall has a position")]
    Velocity(Expr, Symbol),
    /// A wall whose gap has a coordinate of an equation of first order, or one in equations in which the
    /// rate of such a coordinate stands beside an acceleration.
    #[error(
        "the wall `{0} = 0` turns velocities round, but the equation of `{1}` is of first order, and `{1}` is in the gap or in the equation of another coordinate's acceleration: give `{1}` a mass"
    )]
    FirstOrder(Expr, Symbol),
    /// A wall in coupled equations without a mass matrix.
    #[error(
        "the wall `{0} = 0` needs masses: the coefficients of the accelerations are no symmetric matrix, so that no momentum is known"
    )]
    WithoutMass(Expr),
    /// The mass matrix is singular.
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
}

/// The law of impact of a wall in equations of motion of second order.
#[derive(Clone, Debug, PartialEq)]
pub struct WallImpact {
    /// The gap g in coordinates and time.
    pub gap: Expr,
    /// Its rate g' in coordinates, velocities and time.
    pub rate: Expr,
    /// n = dg/dq for each coordinate, zero for those of equations of first order.
    pub normal: Vec<Expr>,
    /// d = M^-1 n for each coordinate: the change of the velocities by a unit of momentum of the wall; zero for
    /// those of equations of first order, which have no velocity.
    pub direction: Vec<Expr>,
}

impl WallImpact {
    /// n . d of two walls: the change of the rate of this gap by a unit of momentum of the other wall.
    pub fn compliance(&self, other: &Self) -> Expr {
        self.normal.iter().zip(&other.direction).map(|(n, d)| n * d).sum()
    }

    /// The velocities after an impact, q' - (1 + e) d g'/(n.d), in the order of the coordinates; of one of an
    /// equation of first order its rate, which an impact leaves as it is.
    ///
    /// # Errors
    /// A failed step of algebra.
    pub fn velocities_after(
        &self,
        coordinates: &[Symbol],
        restitution: &Expr,
    ) -> Result<Vec<Expr>, ExprError> {
        let momentum = (Expr::one() + restitution) * &self.rate;
        let momentum = Expr::divide(&momentum, &self.compliance(self))?;
        let after = |(name, direction): (&Symbol, &Expr)| {
            Expr::from(name.derivative()) - direction * &momentum
        };
        Ok(coordinates.iter().zip(&self.direction).map(after).collect())
    }
}

impl Wall {
    /// Reads the side on which motions are allowed, `x < 1`, and the coefficient of restitution of
    /// its wall; `-1 < x < 1` has two walls.
    ///
    /// # Errors
    /// [`WallError::Parse`].
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::wall::Wall;
    ///
    /// let table = &Wall::parse("x > Z*sin(w*t)", &"e".parse()?)?[0];
    /// assert_eq!(table.gap.to_string(), "x - Z*sin(w*t)");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn parse(bound: &str, restitution: &Expr) -> Result<Vec<Self>, WallError> {
        let gaps = parse_inequality(bound)?.into_iter();
        Ok(gaps.map(|gap| Self { gap, restitution: restitution.clone() }).collect())
    }

    /// The value of the coefficient of restitution.
    ///
    /// # Errors
    /// [`WallError`] if it has no value or is not between 0 and 1.
    pub fn restitution_at(&self, values: &BTreeMap<Symbol, f64>) -> Result<f64, WallError> {
        let value = self.restitution.evaluate(values);
        let value = value.map_err(|error| WallError::Undefined(self.restitution.clone(), error))?;
        match (0.0..=1.0).contains(&value) {
            true => Ok(value),
            false => Err(WallError::Restitution(value)),
        }
    }

    /// The law of impact in equations of these coordinates and states, with the matrix of the
    /// coefficients of the accelerations; for one coordinate it may be left out, since its mass cancels.
    ///
    /// # Errors
    /// [`WallError`] for a gap without a coordinate or with a velocity, a coordinate without a velocity
    /// among the states that is in the gap or in the mass matrix beside others, or coefficients that are not a
    /// mass matrix.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::wall::Wall;
    ///
    /// let table = &Wall::parse("x > Z*sin(w*t)", &"e".parse()?)?[0];
    /// let impact = table.impact(&["x".into()], &["x".into(), "x'".into()], None)?;
    /// let after = impact.velocities_after(&["x".into()], &table.restitution)?;
    /// // The speed relative to the table is turned round.
    /// let relative = (&after[0] - &"w*Z*cos(w*t)".parse()?).expand()?;
    /// let expected = "-e*(x' - w*Z*cos(w*t))".parse::<lindstedt::expr::Expr>()?.expand()?;
    /// assert!((relative - expected).expand()?.is_zero());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn impact(
        &self,
        coordinates: &[Symbol],
        states: &[Symbol],
        mass: Option<&[Vec<Expr>]>,
    ) -> Result<WallImpact, WallError> {
        self.check(coordinates)?;
        for (index, name) in coordinates.iter().enumerate() {
            let is_beside = |mass: &[Vec<Expr>]| {
                let others = (0..mass.len()).filter(|other| *other != index);
                { others }.any(|j| !(mass[index][j].is_zero() && mass[j][index].is_zero()))
            };
            let is_free = states.contains(&name.derivative())
                || !self.gap.contains(*name) && !mass.is_some_and(is_beside);
            if !is_free {
                return Err(WallError::FirstOrder(self.gap.clone(), *name));
            }
        }
        let normal: Vec<Expr> = coordinates
            .iter()
            .map(|name| self.gap.differentiate(*name))
            .collect::<Result<_, _>>()?;
        let closing =
            coordinates.iter().zip(&normal).map(|(name, n)| n * Expr::from(name.derivative()));
        let rate = self.gap.differentiate(Symbol::new("t"))? + closing.sum::<Expr>();
        let direction = match (mass, normal.len()) {
            (None, 1) => normal.clone(),
            (None, _) => return Err(WallError::WithoutMass(self.gap.clone())),
            (Some(mass), _) => {
                for (i, row) in mass.iter().enumerate() {
                    for (j, entry) in row.iter().enumerate().take(i) {
                        if !(entry - &mass[j][i]).expand()?.is_zero() {
                            return Err(WallError::WithoutMass(self.gap.clone()));
                        }
                    }
                }
                let singular = || MechanicsError::Singular(mass.iter().flatten().cloned().sum());
                linear::solution(mass, &normal, states, singular)?
            }
        };
        Ok(WallImpact { gap: self.gap.clone(), rate, normal, direction })
    }

    /// Checks that the gap contains one of these coordinates and no velocity.
    ///
    /// # Errors
    /// [`WallError`].
    pub fn check(&self, coordinates: &[Symbol]) -> Result<(), WallError> {
        let names = self.gap.symbols();
        if let Some(velocity) = names.iter().find(|name| name.primes() > 0) {
            return Err(WallError::Velocity(self.gap.clone(), *velocity));
        }
        if !names.iter().any(|name| coordinates.contains(name)) {
            let coordinates: Vec<String> =
                coordinates.iter().map(|name| format!("`{name}`")).collect();
            return Err(WallError::NoCoordinate {
                gap: self.gap.clone(),
                coordinates: coordinates.join(", "),
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_is_read_with_the_side_on_which_motions_are_allowed() {
        for (bound, gaps) in [
            ("x < d", "d - x"),
            ("x >= 0", "x"),
            ("-1 < x < 1", "1 + x | 1 - x"),
            ("x - y > L", "x - y - L"),
            ("0 ≤ x", "x"),
        ] {
            let walls = Wall::parse(bound, &Expr::one()).expect(bound);
            for (wall, gap) in walls.iter().zip(gaps.split(" | ")) {
                let gap: Expr = gap.parse().unwrap();
                assert!((&wall.gap - &gap).expand().unwrap().is_zero(), "{bound}: {}", wall.gap);
            }
            assert_eq!(walls.len(), gaps.split(" | ").count());
        }
    }

    #[test]
    fn bad_walls_say_why() {
        let x = ["x".into()];
        for (bound, restitution, words) in [
            ("x = 1", "1", "no `<` or `>`"),
            ("x < 1 y", "1", "1 y"),
            ("d < 1", "1", "contains no coordinate"),
            ("x' < 1", "1", "contains the velocity `x'`"),
            ("x < 1", "1.5", "between 0"),
            ("x < 1", "-1/2", "between 0"),
            ("x < 1", "e", "`e`"),
        ] {
            let wall = Wall::parse(bound, &restitution.parse().unwrap());
            let checked = wall.and_then(|walls| {
                walls[0].check(&x).and_then(|()| walls[0].restitution_at(&BTreeMap::new()))
            });
            let error = checked.expect_err(bound).to_string();
            assert!(error.contains(words), "{bound}: {error}");
        }
    }
}

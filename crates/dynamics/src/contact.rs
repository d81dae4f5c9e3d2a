//! Compliant contacts: walls that give way, as forces in any equations of motion.
//!
//! ```text
//! p = max(-g, 0),  p' = -g' = -(n.q' + dg/dt),  n = dg/dq     penetration of the gap g(q, t), its rate
//! M q'' + h(q, q', t) = n N                                   the contact force N along the gradient of the gap
//! N = K p^n                                                   without loss; H. Hertz (1881) for n = 3/2
//! N = K p^n max(1 + lambda p', 0)                             K. H. Hunt, F. R. E. Crossley (1975)
//! N = (K p + c p') H(-g),  or not below zero                  a spring with a dashpot, with and without pull
//! N = max(K p^n + c S(p/d) p', 0),  S(s) = s^2 (3 - 2 s)      the IMPACT function of ADAMS, full damping from the depth d
//! ```
//!
//! In: the gap and the law. Out: the generalised forces, action and reaction in one, which are terms of
//! the equations like any other.
//! (P. Flores, H. M. Lankarani, *Contact Force Models for Multibody Dynamics*, Springer 2016.)

use crate::coupled::CoupledEquations;
use crate::expr::{Expr, ExprError, Function};
use crate::mechanics::EquationsOfMotion;
use crate::symbol::Symbol;
use crate::wall::{Wall, WallError, WallImpact};

/// The loss of a compliant contact.
#[derive(Clone, Debug, PartialEq)]
pub enum ContactLoss {
    /// A contact without loss.
    None,
    /// The factor `max(1 + lambda p', 0)` of Hunt and Crossley: lambda, time per length.
    Factor(Expr),
    /// A dashpot beside the spring, in force as long as the gap is closed.
    Dashpot {
        /// Its coefficient c, force per speed.
        coefficient: Expr,
        /// Whether the contact may pull on the way out.
        pulls: bool,
    },
    /// A dashpot that comes in with the penetration by a cubic step.
    Step {
        /// Its coefficient c in full, force per speed.
        coefficient: Expr,
        /// The penetration d of full damping.
        depth: Expr,
    },
}

/// A wall that gives way.
#[derive(Clone, Debug, PartialEq)]
pub struct CompliantContact {
    /// The gap g in coordinates, time and parameters: negative in contact.
    pub gap: Expr,
    /// The stiffness K: the force at the penetration one at rest.
    pub stiffness: Expr,
    /// The exponent of the penetration.
    pub exponent: Expr,
    /// The loss.
    pub loss: ContactLoss,
}

impl CompliantContact {
    /// The contact force N, by the rate g' of the gap; zero while the gap is open.
    ///
    /// # Errors
    /// A failed step of algebra.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::contact::{CompliantContact, ContactLoss};
    ///
    /// let contact = CompliantContact {
    ///     gap: "d - x".parse()?,
    ///     stiffness: "K".parse()?,
    ///     exponent: "3/2".parse()?,
    ///     loss: ContactLoss::Factor("lambda".parse()?),
    /// };
    /// let force = contact.force(&"-x'".parse()?)?;
    /// assert_eq!(force.to_string(), "K*max(0, x - d)^(3/2)*max(0, 1 + lambda*x')");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn force(&self, rate: &Expr) -> Result<Expr, ExprError> {
        let closed = (-&self.gap).expand()?;
        let closing = (-rate).expand()?;
        let penetration = not_negative(closed.clone())?;
        let elastic = &self.stiffness * &Expr::power(&penetration, &self.exponent)?;
        match &self.loss {
            ContactLoss::None => Ok(elastic),
            ContactLoss::Factor(factor) => {
                Ok(elastic * not_negative(Expr::one() + factor * &closing)?)
            }
            ContactLoss::Dashpot { coefficient, pulls } => {
                // Behind the step the penetration is the closed gap itself.
                let elastic = &self.stiffness * &Expr::power(&closed, &self.exponent)?;
                let force = elastic + coefficient * &closing;
                let force = if *pulls { force } else { not_negative(force)? };
                Ok(Expr::function(Function::Step, vec![closed])? * force)
            }
            ContactLoss::Step { coefficient, depth } => {
                let part = Expr::divide(&penetration, depth)?;
                let part = Expr::function(Function::Minimum, vec![part, Expr::one()])?;
                let step = part.integer_power(2)? * (Expr::from(3) - Expr::from(2) * &part);
                not_negative(elastic + coefficient * &(step * closing))
            }
        }
    }

    /// The generalised force n_i N of each coordinate.
    ///
    /// # Errors
    /// [`WallError`] for a gap without a coordinate or with a velocity, a coordinate without inertia,
    /// or coefficients of the accelerations that are not a mass matrix.
    pub fn generalised_forces(&self, masses: &Masses) -> Result<Vec<Expr>, WallError> {
        let impact = masses.impact(&self.gap)?;
        let force = self.force(&impact.rate)?;
        Ok(impact.normal.iter().map(|normal| normal * &force).collect())
    }

    /// The terms of the contact on the left side of each equation of motion.
    ///
    /// # Errors
    /// As [`Self::generalised_forces`].
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::contact::{CompliantContact, ContactLoss, Masses};
    /// use lindstedt::coupled::CoupledEquations;
    ///
    /// let bodies = CoupledEquations::parse("m*x'' + x = 0; M*y'' = 0")?;
    /// let contact = CompliantContact {
    ///     gap: "y - x".parse()?,
    ///     stiffness: "K".parse()?,
    ///     exponent: "2".parse()?,
    ///     loss: ContactLoss::None,
    /// };
    /// let [one, other] = &contact.left_terms(&Masses::of_equations(&bodies))?[..] else { panic!() };
    /// assert_eq!(one.to_string(), "K*max(0, x - y)^2");
    /// assert_eq!(other.to_string(), "-K*max(0, x - y)^2");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn left_terms(&self, masses: &Masses) -> Result<Vec<Expr>, WallError> {
        let forces = self.generalised_forces(masses)?.into_iter().zip(&masses.is_negative);
        Ok(forces.map(|(force, negative)| if *negative { force } else { -force }).collect())
    }
}

/// `max(expression, 0)`.
fn not_negative(expression: Expr) -> Result<Expr, ExprError> {
    Expr::function(Function::Maximum, vec![expression, Expr::zero()])
}

/// The coordinates of equations of motion and their mass matrix.
#[derive(Clone, Debug)]
pub struct Masses {
    /// The coordinates, in the order of the equations.
    pub coordinates: Vec<Symbol>,
    /// The coordinates, then the velocities of those of second order.
    states: Vec<Symbol>,
    /// The mass matrix.
    matrix: Vec<Vec<Expr>>,
    /// For each equation whether its own acceleration has a minus on the left, `x = x''`.
    is_negative: Vec<bool>,
}

impl Masses {
    /// The masses of equations: the coefficients of the accelerations as the equations are written.
    pub fn of_equations(equations: &CoupledEquations) -> Self {
        let rows = || equations.matrix.iter().enumerate();
        let is_negative: Vec<bool> =
            rows().map(|(index, row)| row[index].has_leading_minus()).collect();
        let signed = |(index, row): (usize, &Vec<Expr>)| match is_negative[index] {
            true => row.iter().map(|entry| -entry).collect(),
            false => row.clone(),
        };
        Self {
            coordinates: equations.coordinates.clone(),
            states: equations.rates.states.clone(),
            matrix: rows().map(signed).collect(),
            is_negative,
        }
    }

    /// The masses of a mechanism: those of its kinetic energy.
    pub fn of_mechanism(equations: &EquationsOfMotion) -> Self {
        let coordinates = equations.coordinates.clone();
        let velocities = coordinates.iter().map(|name| name.derivative());
        Self {
            states: coordinates.iter().copied().chain(velocities).collect(),
            matrix: equations.mass.clone(),
            is_negative: vec![false; coordinates.len()],
            coordinates,
        }
    }

    /// The law of impact at a gap, whose normal and rate a compliant contact shares.
    fn impact(&self, gap: &Expr) -> Result<WallImpact, WallError> {
        let wall = Wall { gap: gap.clone(), restitution: Expr::one() };
        wall.impact(&self.coordinates, &self.states, Some(&self.matrix))
    }

    /// The mass `1/(n.M^-1 n)` that a contact at this gap sees: of two bodies the reduced one.
    ///
    /// # Errors
    /// As [`CompliantContact::generalised_forces`].
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::contact::Masses;
    /// use lindstedt::coupled::CoupledEquations;
    ///
    /// let bodies = CoupledEquations::parse("3*x'' = 0; 6*y'' = 0")?;
    /// let reduced = Masses::of_equations(&bodies).effective(&"y - x".parse()?)?;
    /// assert_eq!(reduced.to_string(), "2");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn effective(&self, gap: &Expr) -> Result<Expr, WallError> {
        let impact = self.impact(gap)?;
        Ok(Expr::divide(&Expr::one(), &impact.compliance(&impact).expand()?)?)
    }
}

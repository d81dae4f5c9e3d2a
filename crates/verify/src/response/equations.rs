//! The equations of a response: of one coordinate, or coupled.

use crate::coupled::{CoupledEquations, CoupledError};
use crate::expr::Expr;
use crate::oscillator::{Oscillator, OscillatorError};
use crate::symbol::Symbol;
use thiserror::Error;

/// The equations of a response.
#[derive(Clone, Debug, PartialEq)]
pub enum Equations {
    /// One coordinate with an equation of second order.
    One(Oscillator),
    /// Any number of coordinates.
    Coupled(CoupledEquations),
}

/// The reason why a text has no equations of motion.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum EquationsError {
    /// The single equation is none of an oscillator.
    #[error(transparent)]
    One(OscillatorError),
    /// The equations are no system.
    #[error(transparent)]
    Coupled(CoupledError),
}

impl Equations {
    /// Reads an equation, or several that are separated by `;`. A single equation of first order is
    /// read as a system of one.
    ///
    /// # Errors
    /// [`EquationsError`].
    ///
    /// ```
    /// # use lindstedt_verify as lindstedt;
    /// use lindstedt::response::Equations;
    ///
    /// assert!(matches!(Equations::parse("x'' + x = cos(t)")?, Equations::One(_)));
    /// let two = Equations::parse("x'' + 2*x = y; y'' + 2*y = x")?;
    /// assert_eq!(two.coordinates(), ["x".into(), "y".into()]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, EquationsError> {
        let coupled = || CoupledEquations::parse(text).map(Self::Coupled);
        if text.contains(';') {
            return coupled().map_err(EquationsError::Coupled);
        }
        match Oscillator::parse(text) {
            Ok(oscillator) => Ok(Self::One(oscillator)),
            Err(OscillatorError::NoAcceleration(_)) if text.contains('\'') => {
                coupled().map_err(EquationsError::Coupled)
            }
            Err(error) => Err(EquationsError::One(error)),
        }
    }

    /// The oscillator of a single coordinate.
    pub fn oscillator(&self) -> Option<&Oscillator> {
        match self {
            Self::One(oscillator) => Some(oscillator),
            Self::Coupled(_) => None,
        }
    }

    /// The coordinates.
    pub fn coordinates(&self) -> Vec<Symbol> {
        match self {
            Self::One(oscillator) => vec![oscillator.coordinate],
            Self::Coupled(equations) => equations.coordinates.clone(),
        }
    }

    /// The coordinates, then the velocities of those whose equations are of second order.
    pub fn states(&self) -> Vec<Symbol> {
        match self {
            Self::One(oscillator) => {
                vec![oscillator.coordinate, oscillator.coordinate.derivative()]
            }
            Self::Coupled(equations) => equations.rates.states.clone(),
        }
    }

    /// The names that need values, in alphabetical order.
    pub fn parameters(&self) -> &[Symbol] {
        match self {
            Self::One(oscillator) => &oscillator.parameters,
            Self::Coupled(equations) => &equations.parameters,
        }
    }

    /// The left and the right side of each equation.
    pub fn sides(&self) -> Vec<(Expr, Expr)> {
        match self {
            Self::One(oscillator) => {
                let equation = oscillator.equation();
                vec![(equation.left, equation.right)]
            }
            Self::Coupled(equations) => equations.equations.clone(),
        }
    }
}

impl std::fmt::Display for Equations {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let sides = self.sides().into_iter();
        let sides: Vec<String> = sides.map(|(left, right)| format!("{left} = {right}")).collect();
        formatter.write_str(&sides.join("; "))
    }
}

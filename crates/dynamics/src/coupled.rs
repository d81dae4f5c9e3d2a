//! Coupled equations of motion of any number of coordinates, as a person writes them.
//!
//! ```text
//! x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0        M(q, q', t) q'' + h(q, q', t) = 0
//! X' = -X + Y; Y' = X - X^3                            first order, or both orders together
//! ```
//!
//! In: the text, or the equations of a mechanism. Out: the coordinates, in the order of the equations
//! in which their derivatives occur first, and the rates of all states, which are the coordinates, then the velocities of
//! those of second order. Accelerations may be coupled: the highest derivatives follow from linear
//! equations (L. Meirovitch, *Fundamentals of Vibrations*, 2001, section 7.2).

mod energy;

use std::collections::{BTreeMap, BTreeSet};

use thiserror::Error;

pub use energy::Energy;

use crate::expr::{Expr, ExprError, ParseError, parse_equations};
use crate::mechanics::{EquationsOfMotion, MechanicsError, Rates, linear};
use crate::symbol::Symbol;

/// Largest number of coordinates.
pub const MOST_COUPLED: usize = 64;

/// Coupled equations of motion.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledEquations {
    /// The left and the right side of each equation.
    pub equations: Vec<(Expr, Expr)>,
    /// The coordinates, in the order of the equations in which their derivatives occur first, or as
    /// [`Self::new`] orders them.
    pub coordinates: Vec<Symbol>,
    /// The coordinates, then the velocities of those of second order; and the rates of each.
    pub rates: Rates,
    /// The names that are neither coordinates, their derivatives nor time, in alphabetical order.
    pub parameters: Vec<Symbol>,
    /// The matrix of the coefficients of the highest derivatives, a row for each equation.
    pub matrix: Vec<Vec<Expr>>,
    /// The energy in the states, where it is known: kinetic and potential energy of a mechanism.
    pub energy: Option<Expr>,
}

/// The reason why a text is not a system of coupled equations.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CoupledError {
    /// An equation has a syntax error.
    #[error(transparent)]
    Parse(Box<ParseError>),
    /// No derivative occurs.
    #[error("no coordinate moves: the equations have no derivative, such as x'' or x'")]
    NoDerivative,
    /// A number of equations that is not that of the coordinates.
    #[error(
        "{} for {}: {}", counted(*.equations, "equation"), counted(.coordinates.len(), "coordinate"),
        named(.coordinates)
    )]
    Count {
        /// The number of equations.
        equations: usize,
        /// The coordinates.
        coordinates: Vec<Symbol>,
    },
    /// More coordinates than are treated.
    #[error("{0} coordinates: {MOST_COUPLED} at most are treated together")]
    TooMany(usize),
    /// A derivative of the third order or higher.
    #[error("`{0}`: derivatives of the first and second order are treated")]
    Order(Symbol),
    /// An equation is not linear in the highest derivatives.
    #[error(
        "the equation `{0}` is not linear in `{1}`: solve it for the highest derivatives first"
    )]
    NotLinear(Expr, Symbol),
    /// The equations do not determine the highest derivatives.
    #[error(
        "the equations do not determine {}: the matrix of their coefficients is singular, as where a coordinate has no mass",
        named(.0)
    )]
    Singular(Vec<Symbol>),
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// The mechanism has no such equations.
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
}

impl CoupledError {
    /// Returns advice on what to write instead; `None` if there is none.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::NoDerivative => {
                Some("such as \"x'' + 2*x - y = 0; y'' + 2*y - x = cos(Omega*t)\"".to_owned())
            }
            Self::Count { equations, coordinates } if *equations > coordinates.len() => Some(
                "a name moves if a derivative of it occurs, such as y'' or y'; an equation without one is a constraint: solve it, and put the \
                 solution into the others"
                    .to_owned(),
            ),
            Self::Count { .. } => Some("each coordinate needs an equation, separated by `;`".to_owned()),
            _ => None,
        }
    }
}

/// A number with its noun: `1 equation`, `2 equations`.
fn counted(count: usize, noun: &str) -> String {
    match count {
        1 => format!("1 {noun}"),
        count => format!("{count} {noun}s"),
    }
}

/// Names in a row.
fn named(names: &[Symbol]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

impl CoupledEquations {
    /// Reads equations that are separated by `;`.
    ///
    /// # Errors
    /// [`CoupledError`].
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::coupled::CoupledEquations;
    ///
    /// let two = CoupledEquations::parse("2*x'' + y'' + x = 0; x'' + y'' + k*y = cos(t)")?;
    /// assert_eq!(two.coordinates, ["x".into(), "y".into()]);
    /// assert_eq!(two.rates.right[2].expand()?.to_string(), "-x + k*y - cos(t)");
    /// assert_eq!(two.parameters, ["k".into()]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, CoupledError> {
        let equations =
            parse_equations(text).map_err(|error| CoupledError::Parse(Box::new(error)))?;
        Self::new(equations)
    }

    /// The equations of a mechanism.
    ///
    /// # Errors
    /// [`CoupledError`].
    pub fn of_mechanism(equations: &EquationsOfMotion) -> Result<Self, CoupledError> {
        let sides = equations.left.iter().map(|left| (left.clone(), Expr::zero())).collect();
        Ok(Self { energy: Some(equations.energy.clone()), ..Self::new(sides)? })
    }

    /// The equations with expressions in place of names, in their energy too.
    ///
    /// # Errors
    /// [`CoupledError`].
    pub fn substituted(&self, values: &BTreeMap<Symbol, Expr>) -> Result<Self, CoupledError> {
        let sides = self
            .equations
            .iter()
            .map(|(left, right)| Ok((left.substitute_all(values)?, right.substitute_all(values)?)));
        let energy = self.energy.as_ref().map(|energy| energy.substitute_all(values));
        let sides = sides.collect::<Result<_, ExprError>>()?;
        let found = Self::in_order(sides, self.coordinates.clone())?;
        Ok(Self { energy: energy.transpose()?, ..found })
    }

    /// Solves equations, given by their sides, for the highest derivatives. Where the matrix of these is
    /// symmetric, the coordinates are in the order in which it may be a mass matrix.
    ///
    /// # Errors
    /// [`CoupledError`].
    pub fn new(equations: Vec<(Expr, Expr)>) -> Result<Self, CoupledError> {
        let found = Self::in_order(equations, vec![])?;
        match found.symmetric_order()? {
            Some(order) => Self::in_order(found.equations, order),
            None => Ok(found),
        }
    }

    /// The order of the coordinates, another one than theirs, in which a symmetric matrix stays symmetric
    /// and has the greatest of its entries on its diagonal, as a positive definite matrix has. The sizes
    /// are those at rest, with numbers in place of the parameters.
    fn symmetric_order(&self) -> Result<Option<Vec<Symbol>>, ExprError> {
        let count = self.coordinates.len();
        let is_symmetric = |order: &[usize]| -> Result<bool, ExprError> {
            for row in 0..count {
                for other in 0..row {
                    let [one, two] =
                        [(row, other), (other, row)].map(|(i, j)| &self.matrix[i][order[j]]);
                    if !(one - two).expand()?.is_zero() {
                        return Ok(false);
                    }
                }
            }
            Ok(true)
        };
        if !is_symmetric(&(0..count).collect::<Vec<usize>>())? {
            return Ok(None);
        }
        let size = |row: usize, column: usize| {
            linear::size_at_rest(&self.matrix[row][column], &self.rates.states)
        };
        let sizes: Vec<Vec<f64>> =
            (0..count).map(|row| (0..count).map(|column| size(row, column)).collect()).collect();
        let mut own: Vec<Option<usize>> = vec![None; count];
        for _ in 0..count {
            let open = (0..count).filter(|row| own[*row].is_none());
            let pairs = open.flat_map(|row| (0..count).map(move |column| (row, column)));
            let free = pairs.filter(|(_, column)| !own.contains(&Some(*column)));
            // Of equal entries the first.
            let largest = free.reduce(|best, next| {
                if sizes[next.0][next.1] > sizes[best.0][best.1] { next } else { best }
            });
            let Some((row, column)) = largest else { return Ok(None) };
            own[row] = Some(column);
        }
        let order: Vec<usize> = own.into_iter().flatten().collect();
        if order.is_sorted() || !is_symmetric(&order)? {
            return Ok(None);
        }
        Ok(Some(order.into_iter().map(|column| self.coordinates[column]).collect()))
    }

    /// Solves equations for the highest derivatives of these coordinates, then of others in the order
    /// in which they occur.
    fn in_order(
        equations: Vec<(Expr, Expr)>,
        mut coordinates: Vec<Symbol>,
    ) -> Result<Self, CoupledError> {
        let residuals: Vec<Expr> = equations.iter().map(|(left, right)| left - right).collect();
        let mut derivatives = BTreeSet::new();
        for (left, right) in &equations {
            for side in [left, right] {
                for name in side.symbols().into_iter().filter(|name| name.primes() > 0) {
                    derivatives.insert(name);
                    if !coordinates.contains(&name.coordinate()) {
                        coordinates.push(name.coordinate());
                    }
                }
            }
        }
        // Values put into a coordinate's terms may leave none of its derivatives.
        coordinates.retain(|name| derivatives.iter().any(|own| own.coordinate() == *name));
        if let Some(name) = derivatives.iter().find(|name| name.primes() > 2) {
            return Err(CoupledError::Order(*name));
        }
        if coordinates.is_empty() {
            return Err(CoupledError::NoDerivative);
        }
        if coordinates.len() != equations.len() {
            return Err(CoupledError::Count { equations: equations.len(), coordinates });
        }
        if coordinates.len() > MOST_COUPLED {
            return Err(CoupledError::TooMany(coordinates.len()));
        }
        let is_second = |name: &Symbol| derivatives.contains(&name.derivative().derivative());
        let highest: Vec<Symbol> = coordinates
            .iter()
            .map(|name| match is_second(name) {
                true => name.derivative().derivative(),
                false => name.derivative(),
            })
            .collect();
        let moving: Vec<Symbol> =
            coordinates.iter().flat_map(|name| [*name, name.derivative()]).collect();
        let (matrix, found) = solved(&residuals, &highest, &moving)?;
        let velocities: Vec<Symbol> = coordinates
            .iter()
            .filter(|name| is_second(name))
            .map(|name| name.derivative())
            .collect();
        let (mut first, mut second) = (Vec::new(), Vec::new());
        for (name, rate) in coordinates.iter().zip(found) {
            match is_second(name) {
                true => {
                    first.push(Expr::from(name.derivative()));
                    second.push(rate);
                }
                false => first.push(rate),
            }
        }
        // A velocity of first order in the equation of another coordinate is its rate.
        let slow: Vec<(Symbol, Expr)> = coordinates
            .iter()
            .zip(&first)
            .filter(|(name, _)| !is_second(name))
            .map(|(name, rate)| (name.derivative(), rate.clone()))
            .collect();
        let slow = slow.into_iter().collect();
        for rate in &mut second {
            *rate = rate.substitute_all(&slow)?;
        }
        let names: BTreeSet<Symbol> = residuals.iter().flat_map(Expr::symbols).collect();
        let is_own = |name: &Symbol| coordinates.contains(&name.coordinate()) || name.name() == "t";
        Ok(Self {
            parameters: names.into_iter().filter(|name| !is_own(name)).collect(),
            rates: Rates {
                states: coordinates.iter().copied().chain(velocities).collect(),
                right: first.into_iter().chain(second).collect(),
            },
            equations,
            coordinates,
            matrix,
            energy: None,
        })
    }

    /// Whether an acceleration is another one where all velocities have the other sign, as damping
    /// makes it.
    ///
    /// # Errors
    /// A failed step of algebra.
    pub fn has_damping(&self) -> Result<bool, ExprError> {
        let velocities = &self.rates.states[self.coordinates.len()..];
        let backward = velocities.iter().map(|name| (*name, -Expr::from(*name))).collect();
        for rate in &self.rates.right[self.coordinates.len()..] {
            if !(rate - &rate.substitute_all(&backward)?).expand()?.is_zero() {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// The matrix of the highest derivatives, and these from linear equations; `moving` are the
/// coordinates and velocities.
fn solved(
    residuals: &[Expr],
    highest: &[Symbol],
    moving: &[Symbol],
) -> Result<(Vec<Vec<Expr>>, Vec<Expr>), CoupledError> {
    let zeros = highest.iter().map(|name| (*name, Expr::zero())).collect();
    let mut matrix = Vec::new();
    let mut right = Vec::new();
    for residual in residuals {
        let mut row = Vec::new();
        for name in highest {
            let slope = match residual.contains(*name) {
                true => residual.differentiate(*name)?.expand()?,
                false => Expr::zero(),
            };
            if let Some(name) = highest.iter().find(|name| slope.contains(**name)) {
                return Err(CoupledError::NotLinear(residual.clone(), *name));
            }
            row.push(slope);
        }
        matrix.push(row);
        right.push(-residual.substitute_all(&zeros)?);
    }
    let singular = || MechanicsError::Singular(residuals[0].clone());
    let found = linear::solution(&matrix, &right, moving, singular)
        .map_err(|_| CoupledError::Singular(highest.to_vec()))?;
    Ok((matrix, found))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damping_changes_with_the_sign_of_velocities() {
        for (equations, expected) in [
            ("x'' + x = y; y'' + y'^2*x + 2*y = x", false),
            ("(1 + x^2)*x'' + x*x'^2 + 2*x - y = 0; y'' + 4*y - x = 0", false),
            ("x'' + x'/5 + x = y; y'' + 2*y = x", true),
            ("x'' + x = y; y'' = x'", true),
            ("x'' + x + abs(x')*x'/9 = y; y'' + 2*y = x", true),
        ] {
            let parsed = CoupledEquations::parse(equations).expect("equations");
            assert_eq!(parsed.has_damping(), Ok(expected), "{equations}");
        }
    }

    /// The matrix is then the mass matrix, which impacts and energies need: a symmetric one in another
    /// order of the rows would give others.
    #[test]
    fn a_symmetric_matrix_has_its_greatest_entries_on_the_diagonal() {
        for (text, order) in [
            ("x'' + 2*y'' + y = 0; 2*x'' + y'' + x = 0", "y x"),
            ("2*x'' + y'' + x = 0; x'' + 2*y'' + y = 0", "x y"),
            ("y'' + 20*y + b''*b = 0; b'' + y''*b + 9*b = 0", "y b"),
            // The matrix is not symmetric: as they occur.
            ("x'' + 5*y'' + y = 0; 2*x'' + 3*y'' + x = 0", "x y"),
            ("r'' + r - b'^2 = 0; 2*b'' + b + b'*r' = 0", "b r"),
        ] {
            let found = CoupledEquations::parse(text).expect(text);
            let names: Vec<String> = found.coordinates.iter().map(ToString::to_string).collect();
            assert_eq!(names.join(" "), order, "{text}");
        }
    }

    #[test]
    fn orders_may_be_mixed_and_masses_coupled() {
        for (text, states, right) in [
            ("X' = -X + Y; Y' = X - X^3", "X Y", "-X + Y | X - X^3"),
            ("x'' + z' + x = 0; z' + z - x = 0", "x z x'", "x' | x - z | z - 2*x"),
            ("y'' = 1 + x; 2*x'' + y'' = y", "y x y' x'", "y' | x' | 1 + x | (y - 1 - x)/2"),
        ] {
            let found = CoupledEquations::parse(text).expect(text);
            let names: Vec<String> = found.rates.states.iter().map(ToString::to_string).collect();
            assert_eq!(names.join(" "), states, "{text}");
            let rates = found.rates.right.iter().map(|rate| rate.expand().unwrap());
            for (rate, expected) in rates.zip(right.split(" | ")) {
                let expected: Expr = expected.parse().unwrap();
                assert!((&rate - &expected).expand().unwrap().is_zero(), "{text}: {rate}");
            }
        }
    }

    #[test]
    fn what_is_no_system_says_why() {
        for (text, words) in [
            ("x + y = 0; y = 1", "no coordinate moves"),
            ("x'' + x - y = 0; y - x^2 = 0", "2 equations for 1 coordinate: `x`"),
            ("x'' + y'' + x = 0", "1 equation for 2 coordinates: `x`, `y`"),
            ("x'' + y'' = x; 2*x'' + 2*y'' = y", "do not determine `x''`, `y''`"),
            ("x''^2 + x - y = 0; y'' + y = 0", "not linear in `x''`"),
            ("x''' + x - y = 0; y'' + y = 0", "x'''"),
            ("x'' + x - y = 0; y'' + 2 y = 0", "2 y = 0"),
        ] {
            let error = CoupledEquations::parse(text).expect_err(text).to_string();
            assert!(error.contains(words), "{text}: {error}");
        }
    }
}

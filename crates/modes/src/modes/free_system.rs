//! The equations of a free motion, `M q'' + K q + f(q, q', q'') = 0`, from those that were written.

use std::collections::BTreeMap;

use num_traits::{Signed, ToPrimitive};

use super::ModeError;
use super::reading::{at_rest, counted_from_rest, polynomial, with_own_names_apart};
use crate::coupled::CoupledEquations;
use crate::exact::Polynomial;
use crate::expr::{Expr, ExprError, ResultSymbols};
use crate::mechanics::EquationsOfMotion;
use crate::series::taylor;
use crate::solution::Definition;
use crate::symbol::Symbol;

/// A free system without damping about its place of rest, where every coordinate is zero.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeSystem {
    /// The equations as they were given; names that are those of something in an answer are
    /// [apart](Symbol::apart).
    pub equations: CoupledEquations,
    /// The place of rest from which each coordinate is counted, in the coordinates of the mechanism;
    /// zeros for equations that were typed.
    pub rest: Vec<Expr>,
    /// The letters of amplitude and frequency beside the names of the equations.
    pub letters: ResultSymbols,
    /// The mass matrix M at rest, a row for each equation.
    pub mass: Vec<Vec<Polynomial>>,
    /// The stiffness matrix K at rest.
    pub stiffness: Vec<Vec<Polynomial>>,
    /// The constants of the equations that are no products of powers, such as `sqrt(2)`, by their
    /// names in polynomials.
    pub constants: Vec<Definition>,
    /// The equations in the order of the rows.
    rows: Vec<usize>,
}

/// A term of f in an equation: a coefficient and powers of the coordinates and their derivatives.
#[derive(Clone, Debug)]
pub(super) struct ForceTerm {
    pub(super) coefficient: Polynomial,
    /// Coordinate, number of derivatives, exponent.
    pub(super) powers: Vec<(usize, usize, u32)>,
}

impl ForceTerm {
    /// The number of factors: the power of the amplitude.
    pub(super) fn degree(&self) -> usize {
        self.powers.iter().map(|(_, _, exponent)| *exponent as usize).sum()
    }

    /// The number of derivatives in time.
    fn derivatives(&self) -> usize {
        self.powers.iter().map(|(_, primes, exponent)| primes * *exponent as usize).sum()
    }

    /// The power of omega^2 that the term has as a function of theta.
    pub(super) fn rates(&self) -> usize {
        self.derivatives() / 2
    }
}

impl FreeSystem {
    /// Reads free equations that are separated by `;`.
    ///
    /// # Errors
    /// [`ModeError`] with the term that is not of such a system.
    ///
    /// ```
    /// # use lindstedt_modes as lindstedt;
    /// use lindstedt::modes::FreeSystem;
    ///
    /// let pair = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; 3*y'' + 2*y - x = 0")?;
    /// assert_eq!(pair.mass[1][1].to_string(), "3");
    /// assert_eq!(pair.stiffness[0][1].to_string(), "-1");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, ModeError> {
        Self::new(CoupledEquations::parse(text)?)
    }

    /// The system of a mechanism, its coordinates counted from the first place of rest that is found.
    ///
    /// # Errors
    /// [`ModeError`] with the term that is not of such a system.
    ///
    /// ```
    /// # use lindstedt_modes as lindstedt;
    /// use lindstedt::mechanics::Mechanism;
    /// use lindstedt::modes::FreeSystem;
    ///
    /// let spring = Mechanism::parse(&["r", "x"], "m*(r'^2 + r^2*x'^2)/2", "k*(r - L)^2/2 - m*g*r*cos(x)")?;
    /// let system = FreeSystem::of_mechanism(&spring.equations()?)?;
    /// assert_eq!(system.rest[0].to_string(), "L + g*m/k");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_mechanism(equations: &EquationsOfMotion) -> Result<Self, ModeError> {
        let (coupled, rest) = counted_from_rest(equations)?;
        Ok(Self { rest, ..Self::new(coupled)? })
    }

    /// The system of coupled equations.
    ///
    /// # Errors
    /// [`ModeError`] with the term that is not of such a system.
    pub fn new(equations: CoupledEquations) -> Result<Self, ModeError> {
        let time = Symbol::new("t");
        let names = equations.coordinates.iter().chain(&equations.parameters);
        let letters = ResultSymbols::avoiding(&names.copied().collect::<Vec<_>>(), false);
        let equations = with_own_names_apart(equations)?;
        let coordinates = &equations.coordinates;
        let slow = coordinates.iter().find(|name| {
            let velocity = name.derivative();
            !equations.rates.states.contains(&velocity)
        });
        if let Some(name) = slow {
            return Err(ModeError::FirstOrder(*name));
        }
        let mut system = Self {
            mass: vec![],
            stiffness: vec![],
            constants: vec![],
            rows: (0..equations.equations.len()).collect(),
            equations: equations.clone(),
            letters,
            rest: vec![Expr::zero(); equations.coordinates.len()],
        };
        let mut damping: Vec<Vec<Expr>> = Vec::new();
        for residual in system.residuals() {
            if residual.contains(time) {
                let written_out = residual.expand()?;
                let driven = written_out.terms().iter().find(|term| term.contains(time));
                return Err(ModeError::Driven(driven.unwrap_or(&residual).clone()));
            }
            let parts = taylor(&residual, &at_rest(coordinates), 1)?;
            let [rest, linear] = [0, 1].map(|degree| parts.get(degree).cloned());
            let rest = rest.unwrap_or_else(Expr::zero).expand()?;
            if coordinates.iter().any(|name| rest.contains(*name)) {
                return Err(ModeError::NoValueAtRest(residual));
            }
            if !rest.is_zero() {
                return Err(ModeError::NotAtRest(residual, rest));
            }
            let linear = linear.unwrap_or_else(Expr::zero);
            let row = |primes: usize| -> Result<Vec<Expr>, ModeError> {
                let slope = |name: &Symbol| {
                    let variable = (0..primes).fold(*name, |name, _| name.derivative());
                    Ok(linear.differentiate(variable)?.expand()?)
                };
                coordinates.iter().map(slope).collect()
            };
            let (stiffness, drag, mass) = (row(0)?, row(1)?, row(2)?);
            damping.push(drag);
            let stiffness = stiffness.iter().map(|entry| system.polynomial(entry)).collect();
            let mass = mass.iter().map(|entry| system.polynomial(entry)).collect();
            system.stiffness.push(stiffness);
            system.mass.push(mass);
        }
        system.check_damping(&damping)?;
        system.order_rows();
        Ok(system)
    }

    /// Puts the equations of two coordinates into the order in which `det M` is positive, as far as
    /// letters are: the root with the minus sign is then the smaller one.
    fn order_rows(&mut self) {
        let [first, second] = self.mass.as_slice() else { return };
        let ([a, b], [c, d]) = (first.as_slice(), second.as_slice()) else { return };
        let mut determinant = b.product(c);
        determinant.negate();
        determinant.accumulate(&a.product(d));
        if determinant.terms().all(|(_, number)| number.is_negative()) {
            self.rows.reverse();
            self.mass.reverse();
            self.stiffness.reverse();
        }
    }

    /// The system with values in place of parameters.
    ///
    /// # Errors
    /// [`ModeError`] where an expression has no value.
    pub fn with_values(&self, values: &BTreeMap<Symbol, Expr>) -> Result<Self, ModeError> {
        let equations = self.equations.substituted(values)?;
        let rest = self.rest.iter().map(|place| place.substitute_all(values));
        Ok(Self {
            letters: self.letters,
            rest: rest.collect::<Result<_, ExprError>>()?,
            ..Self::new(equations)?
        })
    }

    /// The symbol that a typed name means: one of the equations, or a letter of an answer.
    pub fn resolve(&self, name: Symbol) -> Symbol {
        self.letters.resolve(name, &self.names())
    }

    /// Refuses forces that are linear in the velocities.
    fn check_damping(&self, damping: &[Vec<Expr>]) -> Result<(), ModeError> {
        let count = damping.len();
        let skew = (0..count).all(|i| {
            (0..=i)
                .all(|j| (&damping[i][j] + &damping[j][i]).expand().is_ok_and(|sum| sum.is_zero()))
        });
        for row in damping {
            for (slope, name) in row.iter().zip(&self.equations.coordinates) {
                if !slope.is_zero() {
                    let term = slope * &Expr::from(name.derivative());
                    return Err(match skew {
                        true => ModeError::Gyroscopic(term),
                        false => ModeError::Damped(term),
                    });
                }
            }
        }
        Ok(())
    }

    /// The left side of each equation less its right side.
    pub(super) fn residuals(&self) -> Vec<Expr> {
        let sides = self.rows.iter().filter_map(|row| self.equations.equations.get(*row));
        sides.map(|(left, right)| left - right).collect()
    }

    /// The names of the equations: coordinates, parameters, constants, time.
    pub fn names(&self) -> Vec<Symbol> {
        let constants = self.constants.iter().map(|constant| constant.symbol);
        let own = self.equations.coordinates.iter().chain(&self.equations.parameters).copied();
        own.chain(constants).chain([Symbol::new("t")]).collect()
    }

    /// An expression without coordinates as a polynomial.
    fn polynomial(&mut self, expression: &Expr) -> Polynomial {
        polynomial(expression, &self.names(), &mut self.constants)
    }

    /// The terms of f up to a degree, for each equation.
    ///
    /// # Errors
    /// [`ModeError`] for a term that is odd in the velocities, or has no Taylor series.
    pub(super) fn force_terms(&mut self, degree: u32) -> Result<Vec<Vec<ForceTerm>>, ModeError> {
        let variables = at_rest(&self.equations.coordinates);
        let places: BTreeMap<Symbol, (usize, usize)> = variables
            .iter()
            .enumerate()
            .map(|(index, (name, _))| (*name, (index / 3, index % 3)))
            .collect();
        let mut all = Vec::new();
        for residual in self.residuals() {
            let mut terms = Vec::new();
            for part in taylor(&residual, &variables, degree)?.into_iter().skip(2) {
                let written_out = part.expand()?;
                for term in written_out.terms().iter().filter(|term| !term.is_zero()) {
                    let found = self.force_term(term, &places);
                    if found.derivatives() % 2 == 1 {
                        return Err(ModeError::Damped(term.clone()));
                    }
                    terms.push(found);
                }
            }
            all.push(terms);
        }
        Ok(all)
    }

    fn force_term(&mut self, term: &Expr, places: &BTreeMap<Symbol, (usize, usize)>) -> ForceTerm {
        let (number, factors) = term.factors();
        let mut coefficient = Expr::number(number);
        let mut powers = Vec::new();
        for factor in factors {
            let (base, exponent) = factor.base_and_exponent();
            let place = base.as_symbol().and_then(|name| places.get(&name));
            let exponent = exponent
                .as_number()
                .filter(|number| number.is_integer())
                .and_then(|number| number.to_integer().to_u32());
            match (place, exponent) {
                (Some((coordinate, primes)), Some(exponent)) => {
                    powers.push((*coordinate, *primes, exponent));
                }
                _ => coefficient = &coefficient * factor,
            }
        }
        powers.sort_unstable();
        ForceTerm { coefficient: self.polynomial(&coefficient), powers }
    }
}

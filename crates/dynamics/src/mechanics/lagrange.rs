//! Lagrange's equations, and the form in which they are printed.
//!
//! ```text
//! sum_j M_ij q_j'' + h_i = 0      M_ij = d2T/dq_i'dq_j'
//! h_i = sum_j d2T/dq_i'dq_j q_j' + d2T/dq_i'dt - dT/dq_i + dV/dq_i + dD/dq_i' - Q_i
//! ```

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use num_traits::{One, Zero};

use super::combination::{put_into, written_out};
use super::trigonometry::simplified;
use super::{Combination, MechanicsError, Mechanism, linear};
use crate::exact::Rational;
use crate::expr::{Expr, ExprError, Function, Node};
use crate::symbol::Symbol;

/// Equations of motion, one for each coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct EquationsOfMotion {
    /// The coordinates.
    pub coordinates: Vec<Symbol>,
    /// M, the mass matrix.
    pub mass: Vec<Vec<Expr>>,
    /// h, the terms without accelerations on the left side.
    pub rest: Vec<Expr>,
    /// The left sides in the usual form, divided by the common factor of all terms; `x'' + ...` for
    /// a single coordinate if its inertia is a number or a product of parameters.
    pub left: Vec<Expr>,
    /// The divisor of each equation; parameters are taken not to vanish.
    pub divisors: Vec<Expr>,
    /// The sums of parameters that enter as one; the equations above have the sums, not their
    /// names.
    pub combinations: Vec<Combination>,
    /// Kinetic and potential energy together, in coordinates and velocities.
    pub energy: Expr,
}

impl fmt::Display for EquationsOfMotion {
    /// Writes each equation on a line.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines: Vec<String> = self.left.iter().map(|left| format!("{left} = 0")).collect();
        formatter.write_str(&lines.join("\n"))
    }
}

/// Derives the equations of a mechanism that has been checked.
pub(super) fn equations(mechanism: &Mechanism) -> Result<EquationsOfMotion, MechanicsError> {
    let coordinates = &mechanism.coordinates;
    let mut mass = Vec::new();
    let mut rest = Vec::new();
    for coordinate in coordinates {
        let velocity = coordinate.derivative();
        let momentum = mechanism.kinetic.differentiate(velocity)?;
        let row: Result<Vec<Expr>, ExprError> = coordinates
            .iter()
            .map(|other| simplified(&momentum.differentiate(other.derivative())?))
            .collect();
        mass.push(row?);
        let mut terms = vec![
            momentum.differentiate(Symbol::new("t"))?,
            -mechanism.kinetic.differentiate(*coordinate)?,
            mechanism.potential.differentiate(*coordinate)?,
            mechanism.dissipation.differentiate(velocity)?,
        ];
        for other in coordinates {
            terms.push(momentum.differentiate(*other)? * Expr::from(other.derivative()));
        }
        terms.extend(mechanism.forces.get(coordinate).map(|force| -force));
        rest.push(simplified(&Expr::sum(terms))?);
    }
    let singular = || MechanicsError::Singular(mechanism.kinetic.clone());
    // This fails if the mass matrix is singular, so that an acceleration would not follow.
    linear::solution(&mass, &rest, &[], singular)?;
    let mut equations = EquationsOfMotion {
        coordinates: coordinates.clone(),
        mass,
        rest,
        left: Vec::new(),
        divisors: Vec::new(),
        combinations: Vec::new(),
        energy: &mechanism.kinetic + &mechanism.potential,
    };
    for index in 0..coordinates.len() {
        let (left, divisor) = equations.printed(index)?;
        equations.left.push(left);
        equations.divisors.push(divisor);
    }
    Ok(equations)
}

/// Returns a step or a sign by which an energy jumps: one that is not multiplied by a factor that
/// vanishes with its argument. `None` if there is none.
pub(super) fn jump(energy: &Expr, coordinates: &[Symbol]) -> Option<Expr> {
    let steps = |expr: &Expr| {
        expr.contains_function(Function::Step) || expr.contains_function(Function::Sign)
    };
    // The expressions still to be examined, each with the factors that multiply it.
    let mut open: Vec<(Expr, Vec<Expr>)> = vec![(energy.clone(), vec![])];
    while let Some((expr, beside)) = open.pop() {
        match expr.node() {
            Node::Function(Function::Step | Function::Sign, arguments) => {
                let of_motion = arguments[0]
                    .symbols()
                    .into_iter()
                    .any(|name| coordinates.contains(&name.coordinate()));
                if of_motion && !beside.iter().any(|factor| vanishes_with(factor, &arguments[0])) {
                    return Some(expr);
                }
            }
            Node::Product(_, factors) => {
                for (index, factor) in
                    factors.iter().enumerate().filter(|(_, factor)| steps(factor))
                {
                    let others = factors.iter().enumerate().filter(|(other, _)| *other != index);
                    let beside =
                        beside.iter().cloned().chain(others.map(|(_, factor)| factor.clone()));
                    open.push((factor.clone(), beside.collect()));
                }
            }
            _ => open.extend(
                expr.children()
                    .filter(|child| steps(child))
                    .map(|child| (child.clone(), beside.clone())),
            ),
        }
    }
    None
}

/// Whether a factor vanishes with u: a positive power of a multiple of u, or of its sine or
/// absolute value.
fn vanishes_with(factor: &Expr, u: &Expr) -> bool {
    let (base, exponent) = factor.base_and_exponent();
    let positive = exponent.as_number().is_some_and(|exponent| *exponent > Rational::zero());
    let same = |expression: &Expr| {
        let multiple = |name: Symbol| {
            let (above, below) =
                (expression.differentiate(name).ok()?, u.differentiate(name).ok()?);
            let ratio = Expr::divide(&above, &below).ok()?;
            Some(
                !ratio.is_zero()
                    && !ratio.contains(name)
                    && (expression - &(&ratio * u)).expand().ok()?.is_zero(),
            )
        };
        expression == u || u.symbols().into_iter().any(|name| multiple(name) == Some(true))
    };
    let of_wave = match base.node() {
        Node::Function(Function::Sin | Function::Absolute, arguments) => same(&arguments[0]),
        Node::Function(Function::Maximum | Function::Minimum, _) => true,
        _ => false,
    };
    positive && (same(&base) || of_wave)
}

impl EquationsOfMotion {
    /// Returns the equations with the sums in place of the names of these combinations.
    pub(super) fn written_out(mut self, combinations: Vec<Combination>) -> Result<Self, ExprError> {
        let entries = self.mass.iter_mut().flatten();
        let others = self.rest.iter_mut().chain(&mut self.left).chain(&mut self.divisors);
        for entry in entries.chain(others) {
            *entry = written_out(entry, &combinations)?;
        }
        self.energy = written_out(&self.energy, &combinations)?;
        self.combinations = combinations;
        Ok(self)
    }

    /// Returns an expression in terms of the combinations.
    pub(super) fn combined(&self, expression: &Expr) -> Result<Expr, ExprError> {
        put_into(expression, &self.combinations)
    }

    /// Solves the equations for the accelerations: quotients in coordinates, velocities, time and
    /// parameters, not expanded.
    ///
    /// # Errors
    /// [`MechanicsError`] if the mass matrix is singular.
    pub fn accelerations(&self) -> Result<Vec<Expr>, MechanicsError> {
        let right: Vec<Expr> = self.rest.iter().map(|rest| -rest).collect();
        linear::solution(&self.mass, &right, &[], || {
            MechanicsError::Singular(self.mass.iter().flatten().cloned().sum())
        })
    }

    /// The names that are neither coordinates, their derivatives nor time, in alphabetical order.
    pub fn parameters(&self) -> Vec<Symbol> {
        let names: BTreeSet<Symbol> = self.left.iter().flat_map(Expr::symbols).collect();
        names.into_iter().filter(|name| self.is_parameter(*name)).collect()
    }

    /// Whether a name is neither a coordinate, a derivative of one nor time.
    pub(super) fn is_parameter(&self, name: Symbol) -> bool {
        !self.coordinates.contains(&name.coordinate()) && name.name() != "t"
    }

    /// Returns one equation in the usual form, and its divisor.
    fn printed(&self, index: usize) -> Result<(Expr, Expr), ExprError> {
        let inertia = &self.mass[index];
        let accelerations =
            self.coordinates.iter().map(|name| Expr::from(name.derivative().derivative()));
        let rest = self.rest[index].terms().iter().filter(|term| !term.is_zero());
        let terms: Vec<&Expr> = inertia
            .iter()
            .flat_map(Expr::terms)
            .filter(|term| !term.is_zero())
            .chain(rest)
            .collect();
        let own = inertia[index].expand()?;
        let divisor =
            match own.terms().len() == 1 && self.is_constant(&own) && self.coordinates.len() == 1 {
                true => own,
                false => self.common(&terms)?,
            };
        let mut left = Vec::new();
        for (entry, acceleration) in inertia.iter().zip(accelerations) {
            let coefficient = Expr::divide(entry, &divisor)?.expand()?;
            left.push(self.factored(&coefficient)? * acceleration);
        }
        left.push(Expr::divide(&self.rest[index], &divisor)?.expand()?);
        Ok((Expr::sum(left), divisor))
    }

    fn is_constant(&self, expression: &Expr) -> bool {
        expression.symbols().into_iter().all(|name| self.is_parameter(name))
    }

    /// Returns the product of powers of parameters that is common to all terms.
    pub(super) fn common(&self, terms: &[&Expr]) -> Result<Expr, ExprError> {
        let powers: Vec<BTreeMap<Symbol, Rational>> =
            terms.iter().map(|term| self.powers(term)).collect();
        let names: BTreeSet<Symbol> =
            powers.iter().flat_map(|powers| powers.keys().copied()).collect();
        let mut factors = Vec::new();
        for name in names {
            let of = |powers: &BTreeMap<Symbol, Rational>| {
                powers.get(&name).cloned().unwrap_or_else(Rational::zero)
            };
            let least = powers.iter().map(of).min().unwrap_or_else(Rational::zero);
            let most = powers.iter().map(of).max().unwrap_or_else(Rational::zero);
            // The common power is positive in all terms, or in the denominator of all.
            let shared = if most < Rational::zero() { most } else { least };
            if !shared.is_zero() {
                factors.push(Expr::power(&Expr::from(name), &Expr::number(shared))?);
            }
        }
        Ok(Expr::product(factors))
    }

    /// Returns the exponents of the parameters among the factors of a term.
    fn powers(&self, term: &Expr) -> BTreeMap<Symbol, Rational> {
        let (_, factors) = term.factors();
        let power = |factor: &Expr| {
            let (base, exponent) = factor.base_and_exponent();
            let name = base.as_symbol().filter(|name| self.is_parameter(*name))?;
            Some((name, exponent.as_number()?.clone()))
        };
        factors.iter().filter_map(power).collect()
    }

    /// Returns a sum with the common factor of its terms in front.
    fn factored(&self, sum: &Expr) -> Result<Expr, ExprError> {
        let terms: Vec<&Expr> = sum.terms().iter().collect();
        if terms.len() < 2 {
            return Ok(sum.clone());
        }
        let common = self.common(&terms)?;
        match common.as_number().is_some_and(One::is_one) {
            true => Ok(sum.clone()),
            false => Ok(&common * &Expr::divide(sum, &common)?.expand()?),
        }
    }
}

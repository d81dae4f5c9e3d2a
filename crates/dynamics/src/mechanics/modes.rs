//! Small oscillations of a mechanism about an equilibrium.
//!
//! ```text
//! M q'' + C q' + K q = 0,   q = u e^(lambda t)        C = 0, K symmetric: K u = omega^2 M u
//! ```
//!
//! (L. Meirovitch, *Fundamentals of Vibrations*, 2001, sections 7.2 and 7.3.) M, C and K are exact;
//! frequencies and shapes are computed as numbers if every parameter has a value. Contacts,
//! excitation and dry friction are left out, because they are not linear. Excitation means terms
//! with sines and cosines of the time, in M, C and K as well. If the matrices change with the time
//! in another way, as for a pendulum that lengthens, there are no modes.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Cholesky, DMatrix, SymmetricEigen};
use num_traits::Signed;

use super::combination::{put_into, written_out};
use super::equilibrium::undriven;
use super::{
    Combination, EquationsOfMotion, MechanicsError, Rest, RestPosition, trigonometry::simplified,
};
use crate::expr::{Expr, ExprError, Function, Node};
use crate::symbol::Symbol;

/// The linear equations about an equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// The mass matrix M.
    pub mass: Vec<Vec<Expr>>,
    /// The damping matrix C.
    pub damping: Vec<Vec<Expr>>,
    /// The stiffness matrix K.
    pub stiffness: Vec<Vec<Expr>>,
    /// The coordinates that may be anywhere but influence the modes: they are taken at 0.
    pub taken_at_zero: Vec<Symbol>,
    /// A term of these matrices that changes with the time other than by sines and cosines: the
    /// matrices then contain the time, and there are no modes. `None` if there is no such term.
    pub changing: Option<Expr>,
    /// The sums of parameters that enter as one, and cancel as one in [`Modes::square`].
    combinations: Vec<Combination>,
}

/// A mode: an oscillation, or a motion that grows or decays without oscillating.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Angular frequency, in radians per unit of time: |Im lambda|. Zero if the mode does not
    /// oscillate.
    pub frequency: f64,
    /// The growth rate Re lambda, per unit of time: positive if the mode grows.
    pub growth: f64,
    /// The mode shape, scaled so that the largest entry is 1; `None` with damping, whose modes may
    /// be out of phase.
    pub shape: Option<Vec<f64>>,
}

impl Modes {
    /// The linear equations about an equilibrium.
    ///
    /// # Errors
    /// [`MechanicsError`] for derivatives that are too long to be expanded, or undefined there.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::mechanics::{Mechanism, Modes, equilibria};
    ///
    /// let pendulum = Mechanism::parse(&["x"], "m*L^2*x'^2/2", "-m*g*L*cos(x)")?.equations()?;
    /// let [hanging, upright] = &equilibria(&pendulum)?[..] else { unreachable!() };
    /// assert_eq!(Modes::about_rest(&pendulum, hanging)?.square()?.map(|square| square.to_string()), Some("g/L".to_owned()));
    /// assert_eq!(Modes::about_rest(&pendulum, upright)?.square()?.map(|square| square.to_string()), Some("-g/L".to_owned()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn about_rest(equations: &EquationsOfMotion, rest: &Rest) -> Result<Self, MechanicsError> {
        Jacobians::new(equations)?.modes_at(equations, rest)
    }

    /// Returns the parameters that still need a value.
    pub fn parameters(&self) -> BTreeSet<Symbol> {
        let matrices = [&self.mass, &self.damping, &self.stiffness];
        let names = matrices.into_iter().flatten().flatten().flat_map(Expr::symbols);
        names.filter(|name| name.name() != "t").collect()
    }

    /// Returns omega^2 of a single coordinate as a formula; `None` for several coordinates, or if
    /// the equation changes with the time.
    ///
    /// # Errors
    /// [`ExprError`] if the mass vanishes there.
    pub fn square(&self) -> Result<Option<Expr>, ExprError> {
        match (self.mass.as_slice(), self.stiffness.as_slice()) {
            _ if self.changing.is_some() => Ok(None),
            ([mass], [stiffness]) => {
                let [stiffness, mass] =
                    [&stiffness[0], &mass[0]].map(|entry| put_into(entry, &self.combinations));
                let square = Expr::divide(&stiffness?, &mass?)?.expand()?;
                written_out(&square, &self.combinations).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// Computes the modes, the slowest first.
    ///
    /// # Errors
    /// [`MechanicsError`].
    pub fn numbers(&self, values: &BTreeMap<Symbol, f64>) -> Result<Vec<Mode>, MechanicsError> {
        if let Some(changing) = &self.changing {
            return Err(MechanicsError::Changing(changing.clone()));
        }
        let matrix = |rows: &[Vec<Expr>]| -> Result<DMatrix<f64>, MechanicsError> {
            let mut numbers = Vec::new();
            for entry in rows.iter().flatten() {
                numbers.push(entry.evaluate(values)?);
            }
            match numbers.iter().all(|number| number.is_finite()) {
                true => Ok(DMatrix::from_row_slice(rows.len(), rows.len(), &numbers)),
                false => Err(MechanicsError::NotFinite),
            }
        };
        let (mass, damping, stiffness) =
            (matrix(&self.mass)?, matrix(&self.damping)?, matrix(&self.stiffness)?);
        let factor = Cholesky::new(mass).ok_or(MechanicsError::Mass)?;
        let symmetric = (&stiffness - stiffness.transpose()).amax() <= 1e-12 * stiffness.amax();
        let mut modes = match damping.amax() == 0.0 && symmetric {
            true => undamped(&factor, &stiffness),
            false => damped(&factor, &damping, &stiffness),
        };
        modes.sort_by(|one, other| {
            (one.frequency, one.growth)
                .partial_cmp(&(other.frequency, other.growth))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        match modes.iter().all(|mode| mode.frequency.is_finite() && mode.growth.is_finite()) {
            true => Ok(modes),
            false => Err(MechanicsError::NotFinite),
        }
    }
}

/// The Jacobians of the equations with every velocity zero, as functions of the coordinates: the
/// same for all equilibria.
pub(super) struct Jacobians {
    /// Mass, damping and stiffness.
    matrices: [Vec<Vec<Expr>>; 3],
}

impl Jacobians {
    /// Differentiates the equations, without contacts and dry friction.
    ///
    /// # Errors
    /// [`MechanicsError`] for derivatives that are too long to be expanded, or undefined at rest.
    pub(super) fn new(equations: &EquationsOfMotion) -> Result<Self, MechanicsError> {
        let coordinates = &equations.coordinates;
        let velocities = || coordinates.iter().map(|name| name.derivative());
        let still: BTreeMap<Symbol, Expr> = velocities().map(|name| (name, Expr::zero())).collect();
        let (mut damping, mut stiffness) = (Vec::new(), Vec::new());
        for rest in &equations.rest {
            let written_out = rest.expand()?;
            let has = |term: &Expr, function: Function| term.contains_function(function);
            let smooth = written_out.terms().iter();
            let smooth =
                smooth.filter(|term| !has(term, Function::Step) && !has(term, Function::Sign));
            let force: Expr = smooth.cloned().sum();
            let slope = |name: Symbol| force.differentiate(name)?.substitute_all(&still);
            damping.push(velocities().map(slope).collect::<Result<_, ExprError>>()?);
            let force = force.substitute_all(&still)?;
            let slope = |name: &Symbol| force.differentiate(*name);
            stiffness.push(coordinates.iter().map(slope).collect::<Result<_, ExprError>>()?);
        }
        Ok(Self { matrices: [equations.mass.clone(), damping, stiffness] })
    }

    /// The linear equations about an equilibrium.
    ///
    /// # Errors
    /// [`MechanicsError`] for entries that are too long to be expanded, or undefined there.
    pub(super) fn modes_at(
        &self,
        equations: &EquationsOfMotion,
        rest: &Rest,
    ) -> Result<Modes, MechanicsError> {
        let coordinates = &equations.coordinates;
        let mut place = rest.values(coordinates);
        let anywhere: Vec<Symbol> = coordinates
            .iter()
            .zip(&rest.places)
            .filter_map(|(name, place)| (*place == RestPosition::Anywhere).then_some(*name))
            .collect();
        for name in &anywhere {
            place.remove(name);
        }
        let here = |expression: &Expr, place: &BTreeMap<Symbol, Expr>| {
            simplified(&expression.substitute_all(place)?)
        };
        let mut matrices = self.matrices.clone();
        for entry in matrices.iter_mut().flatten().flatten() {
            *entry = here(entry, &place)?;
        }
        let depends =
            |name: &Symbol| matrices.iter().flatten().flatten().any(|entry| entry.contains(*name));
        let taken_at_zero: Vec<Symbol> = anywhere.into_iter().filter(depends).collect();
        let zero: BTreeMap<Symbol, Expr> =
            taken_at_zero.iter().map(|name| (*name, Expr::zero())).collect();
        let changing = changing(matrices.iter().flatten().flatten())?;
        for entry in matrices.iter_mut().flatten().flatten() {
            *entry = here(entry, &zero)?;
            if changing.is_none() {
                *entry = undriven(entry)?;
            }
        }
        let [mass, damping, stiffness] = matrices;
        Ok(Modes {
            mass,
            damping,
            stiffness,
            taken_at_zero,
            changing,
            combinations: equations.combinations.clone(),
        })
    }
}

/// Returns the first term of these entries that changes with the time other than by sines and
/// cosines of it.
fn changing<'a>(entries: impl Iterator<Item = &'a Expr>) -> Result<Option<Expr>, ExprError> {
    let time = Symbol::new("t");
    let is_wave = |part: &Expr| match part.node() {
        Node::Function(Function::Sin | Function::Cos, argument) => argument
            .iter()
            .all(|phase| phase.differentiate(time).is_ok_and(|rate| !rate.contains(time))),
        _ => false,
    };
    // Products of sines and cosines, and of their whole powers, are sums of waves; roots and
    // quotients are not.
    let is_wavy = |factor: &Expr| {
        let (base, exponent) = factor.base_and_exponent();
        let is_whole =
            exponent.as_number().is_some_and(|power| power.is_integer() && !power.is_negative());
        !factor.contains(time) || is_whole && is_wave(&base)
    };
    for entry in entries {
        let written_out = entry.expand()?;
        let term = written_out.terms().iter().find(|term| !term.factors().1.iter().all(is_wavy));
        if let Some(term) = term {
            return Ok(Some(term.clone()));
        }
    }
    Ok(None)
}

/// Size of a value over the largest one up to which it is rounding.
const ROUNDING: f64 = 1e-13;

/// Largest splitting of a double zero by rounding, over the largest value.
const SPLIT: f64 = 1e-6;

/// Solves K u = omega^2 M u as a symmetric problem in w = L^T u, where M = L L^T.
fn undamped(mass: &Cholesky<f64, nalgebra::Dyn>, stiffness: &DMatrix<f64>) -> Vec<Mode> {
    let lower = mass.l();
    let half = lower.solve_lower_triangular(stiffness).unwrap_or_else(|| stiffness.clone());
    let reduced =
        lower.solve_lower_triangular(&half.transpose()).unwrap_or_else(|| stiffness.clone());
    let found = SymmetricEigen::new((&reduced + reduced.transpose()) * 0.5);
    let largest = found.eigenvalues.amax();
    let mode = |index: usize| {
        let square = found.eigenvalues[index];
        let square = if square.abs() <= ROUNDING * largest { 0.0 } else { square };
        let shape = lower
            .transpose()
            .solve_upper_triangular(&found.eigenvectors.column(index).into_owned());
        let size = shape.as_ref().map_or(1.0, |shape| shape[shape.iamax()]);
        Mode {
            frequency: square.max(0.0).sqrt(),
            growth: (-square).max(0.0).sqrt(),
            shape: shape
                .map(|shape| shape.iter().map(|entry| without_rounding(entry / size)).collect()),
        }
    };
    (0..stiffness.nrows()).map(mode).collect()
}

/// Returns a component of a mode shape, zero if it is rounding.
fn without_rounding(proportion: f64) -> f64 {
    if proportion.abs() < ROUNDING { 0.0 } else { proportion }
}

/// Returns the modes of the first-order equations, one for each pair of conjugate eigenvalues
/// lambda.
fn damped(
    mass: &Cholesky<f64, nalgebra::Dyn>,
    damping: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
) -> Vec<Mode> {
    let size = stiffness.nrows();
    let mut first_order = DMatrix::zeros(2 * size, 2 * size);
    first_order.view_mut((0, size), (size, size)).fill_with_identity();
    first_order.view_mut((size, 0), (size, size)).copy_from(&-mass.solve(stiffness));
    first_order.view_mut((size, size), (size, size)).copy_from(&-mass.solve(damping));
    let found = first_order.complex_eigenvalues();
    let largest = found.iter().map(|value| value.norm()).fold(0.0, f64::max);
    // A rigid-body motion is a double zero eigenvalue, which rounding splits into two of the size
    // of its square root. For each zero singular value of the stiffness up to two of the smallest
    // eigenvalues therefore count as zero.
    let stiff = stiffness.clone().singular_values();
    let rigid = stiff.iter().filter(|value| **value <= ROUNDING * stiff.max()).count();
    let mut sizes: Vec<f64> = found.iter().map(|value| value.norm()).collect();
    sizes.sort_by(f64::total_cmp);
    let split = sizes
        .iter()
        .take(2 * rigid)
        .copied()
        .filter(|size| *size <= SPLIT * largest)
        .fold(ROUNDING * largest, f64::max);
    let kept = found.iter().filter(|value| value.im >= 0.0 || value.norm() <= split);
    let clean = |part: f64, norm: f64| {
        if norm <= split || part.abs() <= ROUNDING * largest { 0.0 } else { part }
    };
    let mode = |value: &nalgebra::Complex<f64>| Mode {
        frequency: clean(value.im, value.norm()),
        growth: clean(value.re, value.norm()),
        shape: None,
    };
    kept.map(mode).collect()
}

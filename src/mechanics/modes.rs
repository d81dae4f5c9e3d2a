//! How a mechanism swings near a place of rest.
//!
//! ```text
//! M q'' + C q' + K q = 0,   q = u e^(lambda t)        C = 0, K symmetric: K u = omega^2 M u
//! ```
//!
//! (L. Meirovitch, *Fundamentals of Vibrations*, 2001, sections 7.2 and 7.3.) M, C and K are exact; frequencies and shapes are
//! numbers, by nalgebra, where every parameter has a value. Contacts, excitation and dry friction are left out: they are not linear.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Cholesky, DMatrix, SymmetricEigen};
use thiserror::Error;

use super::combination::{put_into, written_out};
use super::equilibrium::undriven;
use super::{Combination, Equations, MechanicsError, Place, Rest, trigonometry::simplified};
use crate::expr::{EvaluationError, Expr, ExprError, Function};
use crate::symbol::Symbol;

/// The linear equations near a place of rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// M there.
    pub mass: Vec<Vec<Expr>>,
    /// C there.
    pub damping: Vec<Vec<Expr>>,
    /// K there.
    pub stiffness: Vec<Vec<Expr>>,
    /// The coordinates that may be anywhere and on whose place the modes depend: they are taken at 0.
    pub taken_at_zero: Vec<Symbol>,
    /// The sums of parameters that enter as one: they cancel as one.
    combinations: Vec<Combination>,
}

/// A way of swinging, or of leaving.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Angular frequency, in radians per unit of time: |Im lambda|. Zero where it does not swing.
    pub frequency: f64,
    /// Re lambda, per unit of time: positive where it grows.
    pub growth: f64,
    /// The coordinates in proportion, the largest 1; nothing where damping makes them move out of step.
    pub shape: Option<Vec<f64>>,
}

/// Why there are no numbers.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NoModes {
    /// A parameter without a value, or an expression that has none.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// A number that is not finite.
    #[error("mass or stiffness has no finite value there")]
    NotFinite,
    /// A mass matrix that is not positive.
    #[error("the mass matrix is not positive there")]
    Mass,
}

impl Modes {
    /// The linear equations near a place of rest.
    ///
    /// # Errors
    /// Derivatives too long to be written out, or without a value there.
    ///
    /// ```
    /// use lindstedt::mechanics::{Mechanism, Modes, equilibria};
    ///
    /// let pendulum = Mechanism::parse(&["x"], "m*L^2*x'^2/2", "-m*g*L*cos(x)")?.equations()?;
    /// let [hanging, upright] = &equilibria(&pendulum)?[..] else { unreachable!() };
    /// assert_eq!(Modes::at(&pendulum, hanging)?.square()?.map(|square| square.to_string()), Some("g/L".to_owned()));
    /// assert_eq!(Modes::at(&pendulum, upright)?.square()?.map(|square| square.to_string()), Some("-g/L".to_owned()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn at(equations: &Equations, rest: &Rest) -> Result<Self, MechanicsError> {
        let coordinates = &equations.coordinates;
        let mut place = rest.values(coordinates);
        let anywhere: Vec<Symbol> = coordinates
            .iter()
            .zip(&rest.places)
            .filter_map(|(name, place)| (*place == Place::Anywhere).then_some(*name))
            .collect();
        for name in &anywhere {
            place.remove(name);
        }
        let here = |expression: &Expr, place: &BTreeMap<Symbol, Expr>| simplified(&expression.substitute_all(place)?);
        let mut forces = Vec::new();
        for rest in &equations.rest {
            let smooth = undriven(rest)?;
            let smooth = smooth
                .terms()
                .iter()
                .filter(|term| !term.contains_function(Function::Sign));
            forces.push(smooth.cloned().sum::<Expr>());
        }
        let still = coordinates.iter().map(|name| (name.derivative(), Expr::zero()));
        place.extend(still);
        let slopes = |by: &dyn Fn(Symbol) -> Symbol| -> Result<Vec<Vec<Expr>>, ExprError> {
            let row = |force: &Expr| {
                let slope = |name: &Symbol| here(&force.differentiate(by(*name))?, &place);
                coordinates.iter().map(slope).collect()
            };
            forces.iter().map(row).collect()
        };
        let row = |row: &Vec<Expr>| row.iter().map(|entry| here(entry, &place)).collect();
        let mass: Result<Vec<Vec<Expr>>, ExprError> = equations.mass.iter().map(row).collect();
        let mut matrices = [mass?, slopes(&|name| name.derivative())?, slopes(&|name| name)?];
        let depends = |name: &Symbol| matrices.iter().flatten().flatten().any(|entry| entry.contains(*name));
        let taken_at_zero: Vec<Symbol> = anywhere.into_iter().filter(depends).collect();
        let zero: BTreeMap<Symbol, Expr> = taken_at_zero.iter().map(|name| (*name, Expr::zero())).collect();
        for entry in matrices.iter_mut().flatten().flatten() {
            *entry = here(entry, &zero)?;
        }
        let [mass, damping, stiffness] = matrices;
        Ok(Self {
            mass,
            damping,
            stiffness,
            taken_at_zero,
            combinations: equations.combinations.clone(),
        })
    }

    /// The names that still need a value.
    pub fn parameters(&self) -> BTreeSet<Symbol> {
        let matrices = [&self.mass, &self.damping, &self.stiffness];
        matrices
            .into_iter()
            .flatten()
            .flatten()
            .flat_map(Expr::symbols)
            .collect()
    }

    /// omega^2 of one coordinate, as a formula; nothing for several.
    ///
    /// # Errors
    /// A mass that vanishes there.
    pub fn square(&self) -> Result<Option<Expr>, ExprError> {
        match (self.mass.as_slice(), self.stiffness.as_slice()) {
            ([mass], [stiffness]) => {
                let [stiffness, mass] = [&stiffness[0], &mass[0]].map(|entry| put_into(entry, &self.combinations));
                let square = Expr::divide(&stiffness?, &mass?)?.expand()?;
                written_out(&square, &self.combinations).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// The modes in numbers, slowest first.
    ///
    /// # Errors
    /// [`NoModes`].
    pub fn numbers(&self, values: &BTreeMap<Symbol, f64>) -> Result<Vec<Mode>, NoModes> {
        let matrix = |rows: &[Vec<Expr>]| -> Result<DMatrix<f64>, NoModes> {
            let mut numbers = Vec::new();
            for entry in rows.iter().flatten() {
                numbers.push(entry.evaluate(values)?);
            }
            match numbers.iter().all(|number| number.is_finite()) {
                true => Ok(DMatrix::from_row_slice(rows.len(), rows.len(), &numbers)),
                false => Err(NoModes::NotFinite),
            }
        };
        let (mass, damping, stiffness) = (matrix(&self.mass)?, matrix(&self.damping)?, matrix(&self.stiffness)?);
        let factor = Cholesky::new(mass).ok_or(NoModes::Mass)?;
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
        match modes
            .iter()
            .all(|mode| mode.frequency.is_finite() && mode.growth.is_finite())
        {
            true => Ok(modes),
            false => Err(NoModes::NotFinite),
        }
    }
}

/// A value that is rounding beside the largest is none.
const ROUNDING: f64 = 1e-13;

/// How far rounding splits a double zero, over the largest value.
const SPLIT: f64 = 1e-6;

/// K u = omega^2 M u by M = L L^T: symmetric in w = L^T u.
fn undamped(mass: &Cholesky<f64, nalgebra::Dyn>, stiffness: &DMatrix<f64>) -> Vec<Mode> {
    let lower = mass.l();
    let half = lower
        .solve_lower_triangular(stiffness)
        .unwrap_or_else(|| stiffness.clone());
    let reduced = lower
        .solve_lower_triangular(&half.transpose())
        .unwrap_or_else(|| stiffness.clone());
    let found = SymmetricEigen::new((&reduced + reduced.transpose()) * 0.5);
    let largest = found.eigenvalues.amax();
    let mode = |index: usize| {
        let square = found.eigenvalues[index];
        let square = if square.abs() <= ROUNDING * largest {
            0.0
        } else {
            square
        };
        let shape = lower
            .transpose()
            .solve_upper_triangular(&found.eigenvectors.column(index).into_owned());
        let size = shape.as_ref().map_or(1.0, |shape| shape[shape.iamax()]);
        Mode {
            frequency: square.max(0.0).sqrt(),
            growth: (-square).max(0.0).sqrt(),
            shape: shape.map(|shape| shape.iter().map(|entry| tidy(entry / size)).collect()),
        }
    };
    (0..stiffness.nrows()).map(mode).collect()
}

/// A proportion without the noise of rounding.
fn tidy(proportion: f64) -> f64 {
    if proportion.abs() < ROUNDING { 0.0 } else { proportion }
}

/// lambda of the equations of first order, a pair of conjugates once.
fn damped(mass: &Cholesky<f64, nalgebra::Dyn>, damping: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> Vec<Mode> {
    let size = stiffness.nrows();
    let mut first_order = DMatrix::zeros(2 * size, 2 * size);
    first_order.view_mut((0, size), (size, size)).fill_with_identity();
    first_order
        .view_mut((size, 0), (size, size))
        .copy_from(&-mass.solve(stiffness));
    first_order
        .view_mut((size, size), (size, size))
        .copy_from(&-mass.solve(damping));
    let found = first_order.complex_eigenvalues();
    let largest = found.iter().map(|value| value.norm()).fold(0.0, f64::max);
    // A rigid motion is a double zero of the equations, which rounding splits into two of its root: as many of the smallest as the
    // stiffness has such motions are zero.
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
        if norm <= split || part.abs() <= ROUNDING * largest {
            0.0
        } else {
            part
        }
    };
    let mode = |value: &nalgebra::Complex<f64>| Mode {
        frequency: clean(value.im, value.norm()),
        growth: clean(value.re, value.norm()),
        shape: None,
    };
    kept.map(mode).collect()
}

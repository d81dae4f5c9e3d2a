//! The energy of free motions without damping.
//!
//! ```text
//! M q'' = -dV/dq:    E = q'.M q'/2 + V(q) - V(q_0),    V(q) - V(q_0) = -int_0^1 (q - q_0) . M q''(q_0 + s (q - q_0)) ds
//! ```
//!
//! In: equations with a constant symmetric mass matrix, the forces of which have a potential: their
//! derivatives are symmetric. Or a mechanism, whose energies are known.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::CoupledEquations;
use crate::expr::{CompiledFunction, CompiledList, Expr};
use crate::numeric::ode::quadrature::nodes_and_weights;
use crate::symbol::Symbol;

/// The energy of a state.
#[derive(Clone, Debug)]
pub struct Energy(Source);

#[derive(Clone, Debug)]
enum Source {
    /// A function of the states.
    Known(CompiledFunction),
    /// The mass matrix and the rates, with which the energy follows from the work of the forces.
    ByWork(DMatrix<f64>, CompiledList),
}

impl Energy {
    /// The energy of equations with values for all parameters; `None` if they have none that is known.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::coupled::{CoupledEquations, Energy};
    ///
    /// let pair = CoupledEquations::parse("x'' + 2*x - y + x^3 = 0; y'' + 2*y - x = 0")?;
    /// let energy = Energy::new(&pair, &Default::default()).expect("a potential");
    /// // x^2 + y^2 - x y + x^4/4, and half the square of each velocity.
    /// assert!((energy.over(&[0.0; 4], &[1.0, 2.0, 3.0, 0.0]) - 7.75).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(equations: &CoupledEquations, values: &BTreeMap<Symbol, Expr>) -> Option<Self> {
        let states = &equations.rates.states;
        if let Some(energy) = &equations.energy {
            let energy = energy.substitute_all(values).ok()?;
            return CompiledFunction::new(&energy, states).ok().map(Source::Known).map(Self);
        }
        let n = equations.coordinates.len();
        if states.len() != 2 * n {
            return None;
        }
        let numbers = Default::default();
        let mut mass = DMatrix::zeros(n, n);
        for (i, row) in equations.matrix.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                mass[(i, j)] = entry.substitute_all(values).ok()?.evaluate(&numbers).ok()?;
            }
        }
        let right: Vec<Expr> = equations
            .rates
            .right
            .iter()
            .map(|right| right.substitute_all(values))
            .collect::<Result<_, _>>()
            .ok()?;
        let slopes: Vec<Expr> = right[n..]
            .iter()
            .flat_map(|right| states.iter().map(|state| right.differentiate(*state)))
            .collect::<Result<_, _>>()
            .ok()?;
        let slopes = CompiledList::new(&slopes, states).ok()?;
        let is_symmetric = |matrix: &DMatrix<f64>| {
            (matrix - matrix.transpose()).amax() <= 1e-10 * matrix.amax().max(f64::MIN_POSITIVE)
        };
        let has_potential = (0..3).all(|index| {
            // The fractional parts of multiples of a square root are no special places.
            let place = |k: usize| match k < n {
                true => 2.0 * ((index * n + k + 1) as f64 * 3.0_f64.sqrt()).fract() - 1.0,
                false => 0.0,
            };
            let state: Vec<f64> = (0..2 * n).map(place).collect();
            let mut values = vec![f64::NAN; 2 * n * n];
            slopes.call(&state, &mut vec![], &mut values);
            let by_state = DMatrix::from_row_slice(n, 2 * n, &values);
            is_symmetric(&(&mass * by_state.columns(0, n))) && by_state.columns(n, n).amax() == 0.0
        });
        let rates = CompiledList::new(&right, states).ok()?;
        (is_symmetric(&mass) && has_potential).then_some(Self(Source::ByWork(mass, rates)))
    }

    /// The energy of a state over that of a place of rest.
    pub fn over(&self, rest: &[f64], state: &[f64]) -> f64 {
        match &self.0 {
            Source::Known(energy) => energy.call(state) - energy.call(rest),
            Source::ByWork(mass, rates) => {
                let n = mass.nrows();
                let part = |from: usize| DVector::from_column_slice(&state[from..from + n]);
                let (way, velocity) = (part(0) - DVector::from_column_slice(&rest[..n]), part(n));
                let work = |s: f64| {
                    let mut there = rest.to_vec();
                    for i in 0..n {
                        there[i] += s * way[i];
                    }
                    let mut values = vec![f64::NAN; 2 * n];
                    rates.call(&there, &mut vec![], &mut values);
                    way.dot(&(mass * DVector::from_column_slice(&values[n..])))
                };
                let work: f64 =
                    nodes_and_weights(0.0, 1.0).map(|(s, weight)| weight * work(s)).sum();
                0.5 * velocity.dot(&(mass * &velocity)) - work
            }
        }
    }
}

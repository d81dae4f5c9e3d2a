//! The energy of free motions without damping.
//!
//! ```text
//! M q'' = -dV/dq:    E = q'.M q'/2 + V(q) - V(q_0),    V(q) - V(q_0) = -int_0^1 (q - q_0) . M q''(q_0 + s (q - q_0)) ds
//! ```
//!
//! In: equations with a constant symmetric mass matrix, the forces of which have a potential: their
//! derivatives are symmetric. Or a mechanism, whose energies are known.

use nalgebra::{DMatrix, DVector};

use super::flow::Flow;
use super::starts::spread;
use crate::coupled::CoupledEquations;
use crate::expr::{CompiledFunction, Expr};
use crate::numeric::ode::quadrature::nodes_and_weights;
use crate::symbol::Symbol;

/// The energy of a state.
#[derive(Clone, Debug)]
pub(super) enum Energy {
    /// A function of the states.
    Known(CompiledFunction),
    /// The mass matrix, with which the energy follows from the work of the forces.
    ByWork(DMatrix<f64>),
}

impl Energy {
    /// The energy of equations with numbers, whose rates are those of the flow; `None` if they have
    /// none that is known.
    pub(super) fn new(
        equations: &CoupledEquations,
        values: &std::collections::BTreeMap<Symbol, Expr>,
        flow: &Flow,
    ) -> Option<Self> {
        let n = equations.coordinates.len();
        if let Some(energy) = &equations.energy {
            let energy = energy.substitute_all(values).ok()?;
            let states = &equations.rates.states;
            return CompiledFunction::new(&energy, states).ok().map(Self::Known);
        }
        let numbers = Default::default();
        let mut mass = DMatrix::zeros(n, n);
        for (i, row) in equations.matrix.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                mass[(i, j)] = entry.substitute_all(values).ok()?.evaluate(&numbers).ok()?;
            }
        }
        let is_symmetric = |matrix: &DMatrix<f64>| {
            (matrix - matrix.transpose()).amax() <= 1e-10 * matrix.amax().max(f64::MIN_POSITIVE)
        };
        let has_potential = (0..3).all(|index| {
            let place = |k: usize| if k < n { 2.0 * spread(index, k) - 1.0 } else { 0.0 };
            let state: Vec<f64> = (0..2 * n).map(place).collect();
            let slopes = flow.linearised(&state, 0.0, 0.0).by_state;
            is_symmetric(&(&mass * slopes.view((n, 0), (n, n))))
                && slopes.view((n, n), (n, n)).amax() == 0.0
        });
        (is_symmetric(&mass) && has_potential).then_some(Self::ByWork(mass))
    }

    /// The energy of a state over that of a place of rest.
    pub(super) fn over(&self, flow: &Flow, rest: &[f64], state: &[f64]) -> f64 {
        match self {
            Self::Known(energy) => energy.call(state) - energy.call(rest),
            Self::ByWork(mass) => {
                let n = mass.nrows();
                let part = |from: usize| DVector::from_column_slice(&state[from..from + n]);
                let (way, velocity) = (part(0) - DVector::from_column_slice(&rest[..n]), part(n));
                let work = |s: f64| {
                    let mut there = rest.to_vec();
                    for i in 0..n {
                        there[i] += s * way[i];
                    }
                    let force = mass * flow.rates_at(&there, 0.0, 0.0).rows(n, n);
                    way.dot(&force)
                };
                let work: f64 =
                    nodes_and_weights(0.0, 1.0).map(|(s, weight)| weight * work(s)).sum();
                0.5 * velocity.dot(&(mass * &velocity)) - work
            }
        }
    }
}

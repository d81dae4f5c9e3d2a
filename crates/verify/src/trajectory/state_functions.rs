//! Functions of the time and the states of a course, at the values of its parameters.

use super::TrajectoryRequest;
use crate::expr::{CompiledList, EvaluationError, Expr};
use crate::symbol::Symbol;

/// The arguments of compiled functions of the time and the states.
#[derive(Clone, Debug)]
pub(super) struct StateFunctions {
    /// The time, the states and the parameters, in the order of the arguments.
    arguments: Vec<Symbol>,
    /// The values of the parameters.
    numbers: Vec<f64>,
    /// The number of coordinates and velocities.
    states: usize,
    /// The energy; `None` if there is none.
    energy: Option<CompiledList>,
}

impl StateFunctions {
    pub(super) fn new(course: &TrajectoryRequest) -> Self {
        let states = &course.rates.states;
        let moving: Vec<Symbol> = std::iter::once(Symbol::new("t")).chain(states.clone()).collect();
        let constant = course.values.iter().filter(|(name, _)| !moving.contains(name));
        let (names, numbers): (Vec<Symbol>, Vec<f64>) =
            constant.map(|(name, value)| (*name, *value)).unzip();
        let arguments = [moving, names].concat();
        let energy = course.energy.as_ref().filter(|_| course.missing_for_energy().is_empty());
        let energy = energy.and_then(|energy| {
            CompiledList::new(std::slice::from_ref(&energy.value), &arguments).ok()
        });
        Self { arguments, numbers, states: states.len(), energy }
    }

    /// Returns the functions with the numbers of a course that differs in its numbers alone.
    pub(super) fn with_numbers(&self, course: &TrajectoryRequest) -> Self {
        let names = &self.arguments[1 + self.states..];
        let numbers = names.iter().map(|name| course.values.get(name).copied());
        Self { numbers: numbers.map(|number| number.unwrap_or(f64::NAN)).collect(), ..self.clone() }
    }

    /// Compiles expressions.
    ///
    /// # Errors
    /// A symbol without a value.
    pub(super) fn compiled(&self, expressions: &[Expr]) -> Result<CompiledList, EvaluationError> {
        CompiledList::new(expressions, &self.arguments)
    }

    /// The values of a list of this many functions at a state.
    pub(super) fn values(
        &self,
        list: &CompiledList,
        size: usize,
        time: f64,
        state: &[f64],
    ) -> Vec<f64> {
        let mut values = vec![0.0; size];
        self.write_values(list, time, state, &mut values);
        values
    }

    /// Writes the values of a list of functions at a state.
    pub(super) fn write_values(
        &self,
        list: &CompiledList,
        time: f64,
        state: &[f64],
        values: &mut [f64],
    ) {
        list.call_once(&[&[time], &state[..self.states], &self.numbers], values);
    }

    /// The energy of a state; `None` if there is none.
    pub(super) fn energy(&self, time: f64, state: &[f64]) -> Option<f64> {
        let value = self.values(self.energy.as_ref()?, 1, time, state)[0];
        value.is_finite().then_some(value)
    }
}

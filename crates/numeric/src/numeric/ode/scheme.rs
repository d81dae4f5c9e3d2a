//! The one-step methods behind a run, Verner's and, from the crate `differential-equations`, Radau's,
//! and the motion within one of their steps.

use differential_equations::interpolate::Interpolation;
use differential_equations::methods::ImplicitRungeKutta;
use differential_equations::ode::OrdinaryNumericalMethod;

use super::integrate::IntegrationOptions;
use super::sample::{Sample, StateVector};
use super::verner::VernerSteps;

/// A method: a function that starts it, and one for the values within the step just taken.
pub(super) struct Scheme<M, Y> {
    /// Makes a solver with the tolerances of the options, a first step (0: chosen by the solver)
    /// and a longest step, and the number of values, from the first on, that are interpolated.
    pub fresh: fn(&IntegrationOptions, [f64; 2], usize) -> M,
    /// Returns these values at a time within the step; `None` if they cannot be interpolated.
    pub inside: fn(&mut M, f64) -> Option<Y>,
}

/// Verner's 9(8) pair, with its own interpolant.
pub(super) fn explicit<Y: StateVector>() -> Scheme<VernerSteps<Y>, Y> {
    let inside = |method: &mut VernerSteps<Y>, time| method.values_at(time);
    Scheme { fresh: VernerSteps::new, inside }
}

/// Radau IIA of order 5 (E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*, 2nd
/// ed., Springer 1996, section IV.8), which takes long steps where a motion is slow and stiff.
pub(super) fn implicit<S: Sample>()
-> Scheme<impl OrdinaryNumericalMethod<f64, S::Values>, S::Values> {
    let fresh = |options: &IntegrationOptions, [first_step, longest_step]: [f64; 2], _| {
        ImplicitRungeKutta::radau5()
            .rtol(options.relative_tolerance)
            .atol(options.absolute_tolerance)
            .h0(first_step)
            .h_max(longest_step)
            .max_steps(usize::MAX)
    };
    Scheme { fresh, inside: within::<S, _> }
}

fn within<S: Sample, M>(method: &mut M, time: f64) -> Option<S::Values>
where
    M: OrdinaryNumericalMethod<f64, S::Values> + Interpolation<f64, S::Values>,
{
    let ends = ((method.t_prev(), method.y_prev()), (method.t(), method.y()));
    S::between(ends.0, ends.1, time).or_else(|| method.interpolate(time).ok())
}

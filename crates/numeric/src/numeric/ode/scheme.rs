//! The one-step methods behind a run, from the crate `differential-equations`, and the motion
//! within one of their steps.

use differential_equations::error::Error as StepError;
use differential_equations::interpolate::Interpolation;
use differential_equations::methods::{Adaptive, ExplicitRungeKutta, ImplicitRungeKutta, Ordinary};
use differential_equations::ode::OrdinaryNumericalMethod;

use super::integrate::IntegrationOptions;
use super::sample::{Sample, StateVector};

/// A method: a function that starts it, and one for the values within the step just taken.
pub(super) struct Scheme<M, Y> {
    /// Makes a solver with the tolerances of the options, a first step (0: chosen by the solver)
    /// and a longest step.
    pub fresh: fn(&IntegrationOptions, f64, f64) -> M,
    /// Returns the values at a time within the step; `None` if they cannot be interpolated.
    pub inside: fn(&mut M, f64) -> Option<Y>,
}

/// Verner's 9(8) pair, with its own interpolant.
pub(super) fn explicit<Y: StateVector>() -> Scheme<impl OrdinaryNumericalMethod<f64, Y>, Y> {
    type Method<Y> = ExplicitRungeKutta<Ordinary, Adaptive, f64, Y, 9, 16, 21>;
    let fresh = |options: &IntegrationOptions, first_step, longest_step| -> Method<Y> {
        ExplicitRungeKutta::rkv988e()
            .rtol(options.relative_tolerance)
            .atol(options.absolute_tolerance)
            .h0(first_step)
            .h_max(longest_step)
            .max_steps(usize::MAX)
    };
    let inside = |method: &mut Method<Y>, time| {
        let inside: Result<Y, StepError<f64, Y>> = method.interpolate(time);
        inside.ok()
    };
    Scheme { fresh, inside }
}

/// Radau IIA of order 5 (E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*, 2nd
/// ed., Springer 1996, section IV.8), which takes long steps where a motion is slow and stiff.
pub(super) fn implicit<S: Sample>()
-> Scheme<impl OrdinaryNumericalMethod<f64, S::Values>, S::Values> {
    let fresh = |options: &IntegrationOptions, first_step: f64, longest_step: f64| {
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

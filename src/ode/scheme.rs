//! The one-step methods of the library behind a run, and the motion within one of their steps.

use differential_equations::error::Error as StepError;
use differential_equations::interpolate::Interpolation;
use differential_equations::methods::{Adaptive, ExplicitRungeKutta, ImplicitRungeKutta, Ordinary};
use differential_equations::ode::OrdinaryNumericalMethod;

use super::integrate::Options;

/// A method: how to begin, and the state at a time within the step just taken.
pub(super) struct Scheme<M> {
    /// With these tolerances, this first step (0: of its own choice) and this longest step.
    pub fresh: fn(&Options, f64, f64) -> M,
    /// The state within the step.
    pub inside: fn(&mut M, f64) -> Option<[f64; 2]>,
}

/// Verner's 9(8) pair, with its own interpolant.
pub(super) fn explicit() -> Scheme<impl OrdinaryNumericalMethod<f64, [f64; 2]>> {
    type Method = ExplicitRungeKutta<Ordinary, Adaptive, f64, [f64; 2], 9, 16, 21>;
    let fresh = |options: &Options, first_step, longest_step| -> Method {
        ExplicitRungeKutta::rkv988e()
            .rtol(options.relative_tolerance)
            .atol(options.absolute_tolerance)
            .h0(first_step)
            .h_max(longest_step)
            .max_steps(usize::MAX)
    };
    let inside = |method: &mut Method, time| {
        let inside: Result<[f64; 2], StepError<f64, [f64; 2]>> = method.interpolate(time);
        inside.ok()
    };
    Scheme { fresh, inside }
}

/// Radau IIA of order 5 (E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*, 2nd ed., Springer 1996, section
/// IV.8), which takes long steps where a motion is slow and stiff.
pub(super) fn implicit() -> Scheme<impl OrdinaryNumericalMethod<f64, [f64; 2]>> {
    let fresh = |options: &Options, first_step: f64, longest_step: f64| {
        ImplicitRungeKutta::radau5()
            .rtol(options.relative_tolerance)
            .atol(options.absolute_tolerance)
            .h0(first_step)
            .h_max(longest_step)
            .max_steps(usize::MAX)
    };
    Scheme {
        fresh,
        inside: between_ends,
    }
}

/// The cubic that has displacement and velocity of both ends of a step. The accelerations stay out of it: where the motion is
/// stiff they magnify every error of the velocity.
fn between_ends<M: OrdinaryNumericalMethod<f64, [f64; 2]>>(method: &mut M, time: f64) -> Option<[f64; 2]> {
    let (from, length) = (method.t_prev(), method.t() - method.t_prev());
    let ([x, v], [x1, v1]) = (*method.y_prev(), *method.y());
    // In units of the step.
    let (v, v1, rise) = (length * v, length * v1, x1 - x);
    let s = (time - from) / length;
    let (c2, c3) = (3.0 * rise - 2.0 * v - v1, v + v1 - 2.0 * rise);
    let position = x + s * (v + s * (c2 + s * c3));
    let velocity = (v + s * (2.0 * c2 + s * 3.0 * c3)) / length;
    (position.is_finite() && velocity.is_finite()).then_some([position, velocity])
}

//! Hopf points: the parameter at which self-excited motions of amplitude zero begin.
//!
//! ```text
//! f(x, 0; p) = 0,   f_v(x, 0; p) = 0,   omega^2 = f_x(x, 0; p) > 0
//! ```
//!
//! (Y. A. Kuznetsov, *Elements of Applied Bifurcation Theory*, Springer 2004, chapter 3.) In: an
//! equation without drive, a position and a parameter nearby. Out: the equilibrium, the parameter
//! and the frequency of the smallest motions, by Newton's method on the equation itself,
//! independent of the number of harmonics of a balance.

use nalgebra::{Matrix2, Vector2};

use super::driven::Driven;
use crate::numeric::ode::newton::{Progress, newton};

/// An equilibrium whose linearisation is an undamped oscillation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HopfPoint {
    /// The position of the equilibrium.
    pub position: f64,
    /// The parameter.
    pub parameter: f64,
    /// The frequency of the smallest motions.
    pub frequency: f64,
}

/// The Hopf point near a position and a parameter, in units of these lengths; `None` if Newton's
/// method does not converge.
pub fn hopf_point_near(
    driven: &Driven,
    position: f64,
    parameter: f64,
    [size, range]: [f64; 2],
) -> Option<HopfPoint> {
    const MOST: usize = 30;
    const SETTLED: f64 = 1e-12;
    /// Step of the finite differences of the damping, in units of the lengths.
    const DIFFERENCE: f64 = 1e-6;
    let at = |place: Vector2<f64>| [place[0], 0.0, 0.0, place[1]];
    let lengths = Vector2::new(size, range);
    let equations = |place: &Vector2<f64>| {
        let [by_position, by_velocity, by_parameter] = driven.slopes(&at(*place));
        let damping_slope = |index: usize| {
            let mut step = Vector2::zeros();
            step[index] = DIFFERENCE * lengths[index];
            let [before, after] =
                [place - step, place + step].map(|beside| driven.slopes(&at(beside))[1]);
            (after - before) / (2.0 * step[index])
        };
        let matrix = Matrix2::new(by_position, by_parameter, damping_slope(0), damping_slope(1));
        Some((Vector2::new(driven.force(&at(*place)), by_velocity), matrix))
    };
    let judged = |place: &Vector2<f64>, step: &Vector2<f64>| match step[0].abs() <= SETTLED * size {
        _ if !(place[0] + place[1]).is_finite() => Progress::Lost,
        true if step[1].abs() <= SETTLED * range => Progress::Settled,
        _ => Progress::Going,
    };
    let place = newton(Vector2::new(position, parameter), MOST, equations, judged)?;
    let stiffness = driven.slopes(&at(place))[0];
    (stiffness > 0.0).then_some(HopfPoint {
        position: place[0],
        parameter: place[1],
        frequency: stiffness.sqrt(),
    })
}

//! Hopf points: the parameter at which a self-excited motion is born from rest.
//!
//! ```text
//! f(x, 0; p) = 0,   f_v(x, 0; p) = 0,   omega^2 = f_x(x, 0; p) > 0
//! ```
//!
//! (Y. A. Kuznetsov, *Elements of Applied Bifurcation Theory*, Springer 2004, chapter 3.) In: an
//! equation without drive, a place and a parameter nearby. Out: the place of rest, the parameter
//! and the frequency of the smallest motions, by Newton's method on the equation itself, whatever
//! number of harmonics the motions beside it have.

use nalgebra::{Matrix2, Vector2};

use super::driven::Driven;
use crate::numeric::ode::newton::{Progress, newton};

/// A place of rest that small motions neither leave nor approach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HopfPoint {
    /// The place of rest.
    pub position: f64,
    /// The parameter.
    pub parameter: f64,
    /// The frequency of the smallest motions.
    pub frequency: f64,
}

/// The Hopf point near a place and a parameter, measured in these lengths; `None` if Newton's
/// method does not settle.
pub fn hopf_point_near(
    driven: &Driven,
    position: f64,
    parameter: f64,
    [size, range]: [f64; 2],
) -> Option<HopfPoint> {
    const MOST: usize = 30;
    const SETTLED: f64 = 1e-12;
    /// The finite differences of the damping, of the lengths.
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

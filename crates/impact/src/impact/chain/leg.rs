//! The stretch of a chain between its reference energy and a place: time, area, and the delay by
//! damping and dry friction.
//!
//! ```text
//! lag = cos phi (zeta cos phi + min(alpha/sin a, 1))     phi the phase at the place, a the turning point
//! arctan((x + alpha)/x') - arctan(x/x')                  the same delay by friction alone, exact for a linear swing
//! J = int |x|/x' dx,   dJ/dE = 1/A for a linear swing     delay of a quarter by a small constant force
//! ```
//!
//! The reference is that of [`chain`](super).

use super::cycle::later;
use super::swing::{Stretch, SwingAngle, UndampedSwing};
use crate::impact::lanes::Lanes;
use crate::impact::model::Model;

/// A stretch from or to its reference energy.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leg {
    pub time: f64,
    pub area: f64,
    pub length: f64,
    /// Delay of the arrival by damping at the same phase, to first order.
    pub lag: f64,
    /// The part of the delay that is due to dry friction.
    pub rubbed: f64,
    /// The sine and cosine of the phase at its end away from the turning point.
    pub phase: (f64, f64),
}

/// Delay by dry friction of the passage of an angle with this energy on the way from a turning point
/// (direction 1), or its advance on the way to one (-1), relative to the free swing of this energy.
/// Friction shifts the centre of a linear swing of amplitude a by alpha against the motion, so with
/// x = a sin phi there and the speed a cos phi it is arctan((x + alpha)/x') - arctan(x/x'); for the
/// pendulum 1/a is [`slowness`].
pub(super) fn rub_lag(alpha: f64, spot: &SwingAngle, energy: f64, direction: f64) -> f64 {
    if alpha == 0.0 {
        return 0.0;
    }
    let (sine, cosine) = spot.phase(energy);
    let shift = alpha * slowness(energy);
    (shift * cosine).atan2(1.0 + direction * shift * sine)
}

impl Leg {
    /// A leg of the free swing without friction, with this time and area.
    pub fn free(time: f64, area: f64) -> Self {
        Self { time, area, length: 0.0, lag: 0.0, rubbed: 0.0, phase: (0.0, 1.0) }
    }

    /// Delay of the passage of an angle with another energy, compared with the swing at its phase.
    pub fn later(&self, swing: &UndampedSwing, spot: &SwingAngle, energy: f64) -> f64 {
        let phase = (Lanes([self.phase.0]), Lanes([self.phase.1]));
        later(Lanes([swing.energy]), phase, Lanes([spot.half_sine()]), Lanes([energy])).0[0]
    }
}

/// The leg between the turning point of a swing and a spot, which is counted from the bottom away
/// from the turning point.
pub(super) fn leg(model: &Model, swing: &UndampedSwing, spot: &SwingAngle, reach: Stretch) -> Leg {
    let Model { zeta, alpha, .. } = *model;
    let phase = spot.phase(swing.energy);
    let (_, cosine) = phase;
    let (length, rubbed) = match alpha == 0.0 {
        true => (0.0, 0.0),
        false => {
            let turn = SwingAngle::turn(swing.energy).x;
            (turn + spot.x, alpha / turn.sin().max(alpha))
        }
    };
    Leg {
        time: swing.quarter.time + reach.time,
        area: swing.quarter.area + reach.area,
        length,
        lag: cosine * (zeta * cosine + rubbed),
        rubbed: cosine * rubbed,
        phase,
    }
}

/// Delay by a small constant force of the quarter of a swing from its turning point to the bottom,
/// per unit of the force: dJ/dE of J = int |x|/x' dx, which is 1/A for a linear swing.
///
/// ```text
/// J = 2 sum c_n^2 k^(2n + 1),   c_n = (2^n n!)^2/(2n + 1)!,   E = 2 k^2
/// ```
///
/// The series is summed with its pole at the upright position, where (1 - k^2) 2 k dJ/dE = pi/2,
/// taken out; good to 0.5 %.
fn slowness(energy: f64) -> f64 {
    const COEFFICIENTS: [f64; 4] = [1.0, 1.0 / 3.0, 4.0 / 45.0, 64.0 / 1575.0];
    let square = (0.5 * energy).min(1.0);
    let last = std::f64::consts::FRAC_PI_2 - COEFFICIENTS.iter().sum::<f64>();
    let [one, two, three, four] = COEFFICIENTS;
    let sum = one + square * (two + square * (three + square * (four + square * last)));
    0.5 * sum / (square.sqrt() * (1.0 - square)).max(f64::MIN_POSITIVE)
}

//! The main mass while the pendulum rests relative to it, held by friction or pressed against a
//! barrier: one damped mode in closed form.
//!
//! ```text
//! (R + 1) y'' + delta y' + kappa y = f sin(eta t)        y = Re(c exp(s t) + h exp(i eta t))
//! torque = sin x + y'' cos x                             what friction or the barrier must bear
//! ```
//!
//! Friction holds while |torque| <= alpha; a barrier presses while the torque is towards it. The
//! depth of a pendulum that rests in its barrier is neglected.

use nalgebra::Complex;

use super::flight::safe_step;
use super::path::PrimaryState;
use super::{Primary, PrimaryCase};
use crate::impact::model::Side;

/// The main mass with a pendulum at rest; times count from its beginning.
#[derive(Clone, Debug)]
pub(super) struct RestingPendulum {
    begin: f64,
    x: f64,
    /// Exponents and coefficients of y.
    waves: [(Complex<f64>, Complex<f64>); 2],
}

/// The forces that keep the pendulum at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Support {
    /// Dry friction up to this torque.
    Friction(f64),
    /// The barrier of a side.
    Barrier(Side),
}

impl RestingPendulum {
    /// The motion from this state at this time, whose angular velocity counts as zero; `None` where a
    /// number of it overflows.
    pub(super) fn new(case: &PrimaryCase, begin: f64, state: PrimaryState) -> Option<Self> {
        let Primary { mass, stiffness, damping, force, frequency } = case.primary;
        let whole = mass + 1.0;
        let decay = 0.5 * damping / whole;
        let s = Complex::new(-decay, (stiffness / whole - decay * decay).sqrt());
        let drive = Complex::new(0.0, frequency);
        let steady = match force == 0.0 || frequency == 0.0 {
            true => Complex::new(0.0, 0.0),
            false => {
                Complex::new(0.0, -force) * (drive * begin).exp()
                    / (drive * drive * whole + drive * damping + stiffness)
            }
        };
        let (y, speed) = (state.y - steady.re, state.speed - (drive * steady).re);
        let free = Complex::new(y, (s.re * y - speed) / s.im);
        let is_finite = free.norm_sqr().is_finite() && steady.norm_sqr().is_finite();
        is_finite.then_some(Self { begin, x: state.x, waves: [(s, free), (drive, steady)] })
    }

    /// The derivative of this order of y.
    fn derivative(&self, order: i32, t: f64) -> f64 {
        self.waves.iter().map(|(s, c)| (s.powi(order) * c * (s * t).exp()).re).sum()
    }

    /// The state this long after the beginning.
    pub(super) fn point(&self, t: f64) -> PrimaryState {
        let [y, speed] = [0, 1].map(|order| self.derivative(order, t));
        PrimaryState { x: self.x, velocity: 0.0, y, speed }
    }

    /// The state at this time of the motion.
    pub(super) fn state_at(&self, time: f64) -> PrimaryState {
        self.point(time - self.begin)
    }

    /// The time at which the support gives way; `None` if it does not within this time.
    pub(super) fn release(&self, support: Support, time: f64) -> Option<f64> {
        let (sine, cosine) = self.x.sin_cos();
        let bound: f64 =
            self.waves.iter().map(|(s, c)| (s.norm_sqr() * s.norm_sqr()) * c.norm()).sum();
        let bound = bound * cosine.abs();
        let mut t = 0.0;
        for step in 0..MOST_STEPS {
            let torque = sine + cosine * self.derivative(2, t);
            let rate = cosine * self.derivative(3, t);
            let distances = match support {
                Support::Friction(alpha) => [(alpha - torque, rate), (alpha + torque, -rate)],
                Support::Barrier(side) => [(-side.sign() * torque, side.sign() * rate); 2],
            };
            let mut free = f64::INFINITY;
            for (distance, closing) in distances {
                if distance <= NEAR && closing > 0.0 && step > 0 {
                    return Some(t);
                }
                let least = if distance <= NEAR { LEAST } else { 0.0 };
                free = free.min(safe_step(distance, closing, bound).max(least));
            }
            t += free;
            if t >= time {
                return None;
            }
        }
        Some(t)
    }
}

/// The torque that counts as none.
const NEAR: f64 = 1e-13;

/// The least step from a torque that counts as none.
const LEAST: f64 = 1e-6;

/// Largest number of steps.
const MOST_STEPS: usize = 100_000;

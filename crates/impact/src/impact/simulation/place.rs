//! The rest position of a motion: the bottom of its turn, or held above it by a barrier in the way.
//!
//! ```text
//! bottom:   2 pi n, the nearest
//! held:     a barrier at x_c between there and the bottom, pressed in by the weight: gamma d^(3/2) = sin(|x_c - 2 pi n| - d)
//! ```

use std::f64::consts::{PI, TAU};

use crate::impact::hertz;
use crate::impact::model::{Model, Side};
use crate::numeric::ode::root::find_root;

/// A place of rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::impact) struct RestPoint {
    /// The position, rad.
    pub x: f64,
    /// The lowest position of this turn, rad.
    bottom: f64,
    /// The barrier that holds the pendulum above it.
    held: Option<Side>,
}

impl RestPoint {
    /// The position at which a motion at x settles, without friction and excitation; the bottom if
    /// x is not finite.
    pub fn near(model: &Model, x: f64) -> Self {
        // Nearly every motion does.
        if Self::is_first_bottom(model, x) {
            return Self { x: 0.0, bottom: 0.0, held: None };
        }
        let turns = x.abs() >= PI && x.is_finite();
        let bottom = if turns { TAU * (x / TAU).round() } else { 0.0 };
        let held = [Side::Left, Side::Right].into_iter().find_map(|side| {
            let barrier = model.barrier(side).filter(|_| model.gamma > 0.0)?;
            let height = side.sign() * (bottom - barrier);
            (height > 0.0).then_some((side, barrier, height))
        });
        let Some((side, barrier, height)) = held else {
            return Self { x: bottom, bottom, held: None };
        };
        let excess = |depth: f64| hertz::force(model.gamma, depth) - (height - depth).sin();
        let depth = find_root(excess, 0.0, height).unwrap_or(0.0);
        Self { x: barrier + side.sign() * depth, bottom, held: Some(side) }
    }

    /// Whether the position at which a motion at x settles is zero: x lies about the first bottom, and no
    /// barrier beyond it is in the way.
    #[inline]
    pub fn is_first_bottom(model: &Model, x: f64) -> bool {
        x.abs() < PI
            && model.left.is_none_or(|barrier| barrier <= 0.0)
            && model.right.is_none_or(|barrier| barrier >= 0.0)
    }

    /// Height of the rest position above the bottom, rad.
    pub fn height(&self) -> f64 {
        (self.x - self.bottom).abs()
    }

    /// The side on which every swing shows its whole energy: without a barrier, while there is one
    /// on the other side. `None` otherwise; a barrier beyond the upright position does not count.
    pub fn free_side(&self, model: &Model) -> Option<Side> {
        let stands = |barrier: Option<f64>| {
            barrier.is_some_and(|barrier| (barrier - self.bottom).abs() <= PI)
        };
        match (self.held, stands(model.left), stands(model.right)) {
            (Some(Side::Right), ..) | (None, false, true) => Some(Side::Left),
            (Some(Side::Left), ..) | (None, true, false) => Some(Side::Right),
            (None, ..) => None,
        }
    }
}

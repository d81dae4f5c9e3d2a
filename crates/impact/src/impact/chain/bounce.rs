//! The contact as a map: from the speed of touch to that of release, the depth and the time it
//! takes.
//!
//! The law of Hunt and Crossley, (gamma + mu d') d^(3/2), with the force of the swing at the
//! barrier held constant, g = sin(x_c) against the motion inwards:
//!
//! ```text
//! G(-lambda e v) = G(lambda v),  G(z) = z - ln(1 + z),  lambda = mu/gamma     the restitution e, whatever gamma
//! W = G(lambda v)/lambda^2 = (2/5) gamma D^(5/2) + g D                        the depth D;  W = v^2/2 without damping
//! T = (D/v) (tau_0 + tau_1 p + tau_2 p^2),  p = g D/W                         the duration; p = 0 is Hertz, p = 1 free fall
//! tau_0 = 2 int dy/sqrt(1 - y^(5/2)),  tau_1 = dtau/dp at 0,  tau_0 + tau_1 + tau_2 = 4
//! ```
//!
//! The duration is exact at p = 0 and p = 1 and within 1.3 % between them, where the contact is a
//! graze. There the damping of the contact counts for less: lambda v in the first line is taken in
//! proportion to its work along the undamped contact, (1 - p) i(p)/i(0) with i(p) from int y^(3/2)
//! sqrt(1 - p y - (1 - p) y^(5/2)) dy, a straight line between its ends. The losses by viscous
//! damping and dry friction in contact are also their work along the undamped contact.
//!
//! (K. H. Hunt and F. R. E. Crossley, *J. Appl. Mech.* 42 (1975) 440; see [`hunt_crossley`].)

use std::f64::consts::PI;
use std::sync::LazyLock;

use spec_math::cephes64::gamma;

use super::swing::SwingAngle;
use crate::impact::contact::hunt_crossley;
use crate::impact::hertz;
use crate::impact::model::{Model, Side};

/// Numbers of the law d^(3/2) that are the same for every contact.
struct ContactConstants {
    /// tau_0, tau_1, tau_2.
    duration: [f64; 3],
    /// int_0^1 sqrt(1 - y^(5/2)) dy: the area of half a contact in the phase plane in units of v D,
    /// p = 0.
    area: f64,
    /// int_0^1 y^(3/2) sqrt(1 - y^(5/2)) dy: the work of its damping in units of mu v D^(5/2), p =
    /// 0.
    loss: f64,
}

/// The area of half a contact at p = 1, int_0^1 sqrt(1 - y) dy.
const AREA_OF_A_FALL: f64 = 2.0 / 3.0;

/// The work of the damping at p = 1, int_0^1 y^(3/2) sqrt(1 - y) dy = B(5/2, 3/2).
const LOSS_OF_A_FALL: f64 = PI / 16.0;

/// T v/D of a free fall, 2 int_0^1 dy/sqrt(1 - y).
const DURATION_OF_A_FALL: f64 = 4.0;

static NUMBERS: LazyLock<ContactConstants> = LazyLock::new(|| {
    // B(a, -1/2).
    let beta = |a: f64| -2.0 * PI.sqrt() * gamma(a) / gamma(a - 0.5);
    let hertz = hertz::duration_factor();
    let slope = 0.4 * (beta(0.8) - beta(1.4));
    ContactConstants {
        duration: [hertz, slope, DURATION_OF_A_FALL - hertz - slope],
        area: 0.2 * PI.sqrt() * gamma(0.4) / gamma(1.9),
        loss: 4.0 / 15.0,
    }
});

/// The share of the force of the swing in holding the pendulum against the barrier beyond which a
/// contact is not a bounce, because the pendulum leans on the barrier.
const LEANS: f64 = -0.3;

/// The greatest depth, rad, at which the force of the swing may count as constant.
const DEEPEST: f64 = 0.3;

/// A barrier with the numbers that determine its contacts.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChainBarrier {
    /// The side of the barrier.
    pub side: Side,
    /// Its angle from the bottom, positive on its own side.
    pub spot: SwingAngle,
    gamma: f64,
    /// gamma^(-2/5).
    softness: f64,
    /// lambda = mu/gamma.
    damping: f64,
    /// The force of the swing there, against the motion inwards.
    push: f64,
    zeta: f64,
    alpha: f64,
}

/// The change of the motion by one contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounce {
    /// The greatest depth, rad.
    pub depth: f64,
    /// The duration, in units of 1/omega.
    pub duration: f64,
    /// The speed of release.
    pub speed_out: f64,
}

impl ChainBarrier {
    /// The barrier of this side, where there is one.
    pub fn from_model(model: &Model, side: Side) -> Option<Self> {
        let x = model.barrier(side).filter(|_| model.gamma > 0.0)?;
        let spot = SwingAngle::new(side.sign() * x);
        Some(Self {
            side,
            spot,
            gamma: model.gamma,
            softness: model.gamma.powf(-0.4),
            damping: model.mu / model.gamma,
            push: spot.x.sin(),
            zeta: model.zeta,
            alpha: model.alpha,
        })
    }

    /// The contact that begins with this speed, positive; `None` if the pendulum leans on the
    /// barrier rather than leaves it, or goes deep.
    pub fn bounce(&self, speed: f64) -> Option<Bounce> {
        let product = self.damping * speed;
        let excess = hunt_crossley::excess(product);
        let work = 0.5 * speed * speed * (1.0 + excess);
        let depth = self.depth(work);
        let share = self.push * depth / work;
        if share.is_nan() || share < LEANS || depth > DEEPEST {
            return None;
        }
        let ContactConstants { duration: [zeroth, first, second], area, loss } = &*NUMBERS;
        // lambda v counts in proportion to the work of the damping, which is less if the force of
        // the swing takes a share.
        let loss = hunt_crossley::loss(
            product * (1.0 - share) * (1.0 + share * (LOSS_OF_A_FALL / loss - 1.0)),
        );
        let duration =
            depth / (speed * (1.0 + excess).sqrt()) * (zeroth + share * (first + share * second));
        let area = area + share * (AREA_OF_A_FALL - area);
        let taken =
            (2.0 - loss) * self.zeta * 2.0 * area * speed * depth + 2.0 * self.alpha * depth;
        let released = (1.0 - loss) * speed;
        Some(Bounce {
            depth,
            duration,
            speed_out: (released * released - 2.0 * taken).max(0.0).sqrt(),
        })
    }

    /// The depth at which the barrier and the force of the swing have done this work.
    fn depth(&self, work: f64) -> f64 {
        // The start neglects the force of the swing; the function is convex, so that Newton's steps
        // then descend to the root.
        let mut depth = self.softness * (2.5 * work).powf(0.4);
        if self.push == 0.0 {
            return depth;
        }
        for _ in 0..MOST_STEPS {
            let force = self.gamma * depth * depth.sqrt();
            let step = (0.4 * force * depth + self.push * depth - work) / (force + self.push);
            depth -= step;
            if step.abs() <= 1e-7 * depth {
                break;
            }
        }
        depth
    }
}

/// Largest number of Newton's steps: each doubles the digits, but a graze needs some steps before.
const MOST_STEPS: usize = 60;

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
use crate::impact::lanes::{Lanes, Mask};
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
    contact: Contacts<1>,
}

/// The change of the motion by one contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::impact) struct Bounce {
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
        let contact = Contacts {
            gamma: Lanes([model.gamma]),
            damping: Lanes([model.mu / model.gamma]),
            push: Lanes([spot.x.sin()]),
            zeta: Lanes([model.zeta]),
            alpha: Lanes([model.alpha]),
        };
        Some(Self { side, spot, contact })
    }

    /// The contact that begins with this speed, positive; `None` if the pendulum leans on the
    /// barrier rather than leaves it, or goes deep.
    pub fn bounce(&self, speed: f64) -> Option<Bounce> {
        self.contact.bounces(Lanes([speed])).lane(0)
    }
}

/// The numbers of several barriers.
#[derive(Debug, Clone, Copy)]
pub(in crate::impact) struct Contacts<const L: usize> {
    /// The stiffness.
    pub gamma: Lanes<L>,
    /// lambda = mu/gamma.
    pub damping: Lanes<L>,
    /// The force of the swing there, against the motion inwards.
    pub push: Lanes<L>,
    /// The viscous damping.
    pub zeta: Lanes<L>,
    /// The dry friction.
    pub alpha: Lanes<L>,
}

/// Several contacts.
#[derive(Debug, Clone, Copy)]
pub(in crate::impact) struct Bounces<const L: usize> {
    depth: Lanes<L>,
    duration: Lanes<L>,
    speed_out: Lanes<L>,
    /// The lanes in which the pendulum leaves the barrier and does not go deep.
    is_bounce: Mask<L>,
}

impl<const L: usize> Bounces<L> {
    /// One of them; `None` if it is no bounce.
    pub fn lane(&self, lane: usize) -> Option<Bounce> {
        let Self { depth, duration, speed_out, is_bounce } = self;
        is_bounce.0[lane].then(|| Bounce {
            depth: depth.0[lane],
            duration: duration.0[lane],
            speed_out: speed_out.0[lane],
        })
    }
}

impl<const L: usize> Contacts<L> {
    /// The contacts of these barriers, lane by lane.
    pub(super) fn of(barriers: [&ChainBarrier; L]) -> Self {
        let gathered = |number: fn(&Contacts<1>) -> Lanes<1>| {
            Lanes(barriers.map(|barrier| number(&barrier.contact).0[0]))
        };
        Self {
            gamma: gathered(|own| own.gamma),
            damping: gathered(|own| own.damping),
            push: gathered(|own| own.push),
            zeta: gathered(|own| own.zeta),
            alpha: gathered(|own| own.alpha),
        }
    }

    /// The contacts that begin with these speeds.
    #[inline(always)]
    pub fn bounces(&self, speed: Lanes<L>) -> Bounces<L> {
        let product = self.damping * speed;
        let excess = hunt_crossley::excesses(product);
        let work = 0.5 * speed * speed * (1.0 + excess);
        let depth = self.depths(work);
        let share = self.push * depth / work;
        let ContactConstants { duration: [zeroth, first, second], area, loss } = &*NUMBERS;
        // lambda v counts in proportion to the work of the damping, which is less if the force of
        // the swing takes a share.
        let loss = hunt_crossley::losses(
            product * (1.0 - share) * (1.0 + share * (LOSS_OF_A_FALL / loss - 1.0)),
        );
        let duration = depth / (speed * (1.0 + excess).sqrt())
            * (*zeroth + share * (*first + share * *second));
        let area = *area + share * (AREA_OF_A_FALL - area);
        let taken =
            (2.0 - loss) * self.zeta * 2.0 * area * speed * depth + 2.0 * self.alpha * depth;
        let released = (1.0 - loss) * speed;
        let leans = share.is_at_least(LEANS).not();
        Bounces {
            depth,
            duration,
            speed_out: (released * released - 2.0 * taken).at_least(0.0).sqrt(),
            is_bounce: leans.or(depth.is_above(Lanes::all(DEEPEST))).not(),
        }
    }

    /// The depths at which the barriers and the force of the swing have done this work.
    #[inline(always)]
    fn depths(&self, work: Lanes<L>) -> Lanes<L> {
        // The start neglects the force of the swing; the function is convex, so that Newton's steps
        // then descend to the root.
        let root = (2.5 * work / self.gamma).fifth_root();
        let mut depth = root * root;
        let mut is_open = Mask([true; L]);
        for _ in 0..MOST_STEPS {
            let force = self.gamma * depth * depth.sqrt();
            let step = (0.4 * force * depth + self.push * depth - work) / (force + self.push);
            depth = is_open.select(depth - step, depth);
            is_open = is_open.and(step.abs().is_above(1e-7 * depth));
            if !is_open.any() {
                break;
            }
        }
        depth
    }
}

/// Largest number of Newton's steps: each doubles the digits, but a graze needs some steps before.
const MOST_STEPS: usize = 60;

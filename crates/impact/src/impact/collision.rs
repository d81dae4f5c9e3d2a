//! The collision: a swing released from rest, and an elastic barrier in its way.
//!
//! ```text
//! x'' + f(x) + gamma F(x - x_c) H(x - x_c) = 0,   x(0) = x_r < x_c,  x'(0) = 0
//! v^2/2 = V(x_r) - V(x_c) = - int_(x_r)^(x_c) f                  the speed at the touch, from the energy
//! ```
//!
//! In: the two forces as closures, release and barrier in the units of the equation. Out: a
//! [`Collision`], the problem for closed forms and verification alike, and the speed at the touch;
//! or the reason why there is no touch. The barrier is on the right; a motion to the left is
//! mirrored.

use thiserror::Error;

use super::contact::Dashpot;
use super::linearisation::work;
use crate::numeric::ode::quadrature::{QuadratureError, integrate_smooth};
use crate::numeric::ode::root::find_root;

/// x'' + f(x) + gamma F(x - x_c) = 0, released at rest from x = release towards the barrier at x_c,
/// to the right of it.
#[derive(Clone, Copy)]
pub struct Collision<'a> {
    /// The position of the release, in the unit of x.
    pub release: f64,
    /// Position x_c of the barrier, in the unit of x.
    pub barrier: f64,
    /// Stiffness gamma > 0 of the barrier, equation (8) for a pendulum.
    pub stiffness: f64,
    /// f(x), the force of the swing without the barrier.
    pub restoring_force: &'a dyn Fn(f64) -> f64,
    /// F(depth), the elastic force of the barrier per unit of gamma, such as
    /// [`hertz::elastic_force`](super::hertz::elastic_force); asked for depths of at least zero
    /// only.
    pub elastic_force: &'a dyn Fn(f64) -> f64,
    /// lambda >= 0: the barrier pushes with gamma F(d) (1 + lambda d'), and never pulls; zero where
    /// nothing is lost in it.
    pub damping: f64,
    /// A dashpot in place of that law: the barrier pushes with gamma (F(d) + F(1) lambda d'), F a spring, and
    /// may pull.
    pub dashpot: Option<Dashpot>,
}

/// Restitution, speed out and energy lost per unit of mass, of a contact with these speeds in and
/// out.
pub(super) fn losses([inwards, outwards]: [f64; 2]) -> [f64; 3] {
    let lost = 0.5 * (inwards - outwards) * (inwards + outwards);
    [outwards / inwards, outwards, lost]
}

/// The reason why there is no collision.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum CollisionError {
    /// The amplitude is not a positive number.
    #[error("the amplitude must be a positive number, not {0}: the release is at x = -amplitude")]
    Amplitude(f64),
    /// The release is not a finite number.
    #[error("the release must be a finite number, not {0}")]
    Release(f64),
    /// A swing whose energy is not a number.
    #[error(
        "the amplitude {0:e} is too small: its energy, A^2, underflows; below 1e-8 or so the swing is linear, scale it up"
    )]
    TooSmall(f64),
    /// The barrier is not a finite number.
    #[error("the position of the barrier must be a finite number, not {0}")]
    Barrier(f64),
    /// The barrier has no stiffness.
    #[error(
        "the stiffness gamma of the contact must be a positive number, not {0}: without a barrier the motion is the \
         free swing"
    )]
    Stiffness(f64),
    /// The swing does not go as far as the barrier.
    #[error(
        "the pendulum never reaches the barrier: released at x = {release} it swings no further than {furthest}, and \
         the barrier stands at {barrier}: raise the amplitude or move the barrier"
    )]
    NeverReaches {
        /// The position of the release.
        release: f64,
        /// The furthest point.
        furthest: f64,
        /// The position of the barrier.
        barrier: f64,
    },
    /// The release is at or beyond the barrier.
    #[error(
        "the release at x = {release} lies at or behind the barrier at {barrier}: raise the amplitude or move the \
         barrier"
    )]
    ReleasedBehindBarrier {
        /// The position of the release.
        release: f64,
        /// The position of the barrier.
        barrier: f64,
    },
    /// Released inside the barrier, it does not leave it, or does not come back.
    #[error(
        "released at rest at x = {release}, inside the barrier at {barrier}, it {what}: move the release, or follow the motion by \
         `lindstedt simulate`"
    )]
    Inside {
        /// The position of the release.
        release: f64,
        /// The position of the barrier.
        barrier: f64,
        /// The motion that follows, in words.
        what: &'static str,
    },
    /// The force does not drive the pendulum towards the barrier, at the release or on the way.
    #[error(
        "released at rest at x = {release}, the pendulum does not swing to the barrier: the force turns it back at \
         x = {at}; the amplitude must stay inside the well (below pi for sin x)"
    )]
    OutsideTheWell {
        /// The position of the release.
        release: f64,
        /// The position at which the kinetic energy would be negative or the force points the wrong
        /// way.
        at: f64,
    },
    /// The energy of the swing could not be integrated.
    #[error("the potential of the restoring force could not be integrated: {0}")]
    Potential(#[from] QuadratureError),
}

impl CollisionError {
    /// Returns the error with positions in the coordinate of the equation: x = origin + sign z.
    pub(super) fn seen_from(self, sign: f64, origin: f64) -> Self {
        let x = |z: f64| origin + sign * z;
        match self {
            Self::NeverReaches { release, furthest, barrier } => Self::NeverReaches {
                release: x(release),
                furthest: x(furthest),
                barrier: x(barrier),
            },
            Self::ReleasedBehindBarrier { release, barrier } => {
                Self::ReleasedBehindBarrier { release: x(release), barrier: x(barrier) }
            }
            Self::Inside { release, barrier, what } => {
                Self::Inside { release: x(release), barrier: x(barrier), what }
            }
            Self::OutsideTheWell { release, at } => {
                Self::OutsideTheWell { release: x(release), at: x(at) }
            }
            other => other,
        }
    }
}

/// Smallest amplitude whose square, and the square of whose depth, do not underflow.
const SMALLEST_AMPLITUDE: f64 = 1e-120;

impl Collision<'_> {
    /// The force of the barrier at this depth and speed inwards, its loss included.
    pub(super) fn contact_force(&self, depth: f64, inwards: f64) -> f64 {
        let elastic = (self.elastic_force)(depth.max(0.0));
        let lossy = match self.dashpot {
            None => elastic * (1.0 + self.damping * inwards).max(0.0),
            Some(dashpot) => {
                let force = elastic + (self.elastic_force)(1.0) * self.damping * inwards;
                if dashpot == Dashpot::Pulls { force } else { force.max(0.0) }
            }
        };
        self.stiffness * lossy
    }

    /// Checks that the numbers describe a collision.
    ///
    /// # Errors
    /// [`CollisionError`].
    pub(super) fn check(&self) -> Result<(), CollisionError> {
        let &Collision { release, barrier, stiffness, .. } = self;
        if !release.is_finite() {
            return Err(CollisionError::Release(release));
        }
        if release.abs() < SMALLEST_AMPLITUDE {
            return Err(CollisionError::TooSmall(release.abs()));
        }
        if !barrier.is_finite() {
            return Err(CollisionError::Barrier(barrier));
        }
        // The farthest point of a symmetric swing is the mirror image of the release.
        let furthest = release.abs();
        if barrier >= furthest && release < 0.0 || release > 0.0 && barrier > release {
            return Err(CollisionError::NeverReaches { release, furthest, barrier });
        }
        if barrier <= release {
            return Err(CollisionError::ReleasedBehindBarrier { release, barrier });
        }
        if !(stiffness.is_finite() && stiffness > 0.0) {
            return Err(CollisionError::Stiffness(stiffness));
        }
        Ok(())
    }

    /// The turning point on the free side of a motion released at rest at `inside`, beyond the
    /// barrier: where V(x) - V(x_c) = V(inside) - V(x_c) + gamma int_0^(inside - x_c) F. The field
    /// `release` is not used.
    ///
    /// # Errors
    /// [`CollisionError::Inside`] where the barrier does not push it out, or the swing does not
    /// bring it back.
    pub(super) fn turning_point(&self, inside: f64) -> Result<f64, CollisionError> {
        let &Collision { barrier, stiffness, restoring_force, elastic_force, .. } = self;
        let stays = |what| CollisionError::Inside { release: inside, barrier, what };
        let depth = inside - barrier;
        let stored = stiffness * work(elastic_force, depth)?;
        let energy = stored + integrate_smooth(restoring_force, barrier, inside, 1e-13)?.0;
        if energy.is_nan() || energy <= 0.0 {
            return Err(stays("is not pushed out of it"));
        }
        let missing = |x: f64| match integrate_smooth(restoring_force, x, barrier, 1e-13) {
            Ok((gained, _)) => -gained - energy,
            Err(_) => f64::NAN,
        };
        // The search takes slowly growing steps, so that no hill of the potential is stepped over.
        let mut step = 1e-6 * depth.max(barrier.abs());
        let (mut near, mut far) = (barrier, barrier - step);
        for _ in 0..400 {
            let value = missing(far);
            if value.is_nan() {
                break;
            }
            if value >= 0.0 {
                return find_root(missing, far, near)
                    .map_err(|_| stays("does not come to rest on the other side"));
            }
            step *= 1.1;
            (near, far) = (far, far - step);
        }
        Err(stays("does not come to rest on the other side"))
    }

    /// The speed sqrt(2 (V(x_r) - V(x_c))) at the barrier, from the energy, in the units of x and
    /// time of the equation.
    ///
    /// # Errors
    /// [`CollisionError::OutsideTheWell`] where the released pendulum does not swing that far.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::{Collision, hertz::elastic_force};
    ///
    /// let pendulum = Collision {
    ///     release: -1.5,
    ///     barrier: 0.323,
    ///     stiffness: 1e6,
    ///     restoring_force: &f64::sin,
    ///     elastic_force: &elastic_force,
    ///     damping: 0.0,
    ///     dashpot: None,
    /// };
    /// let exact = (2.0 * (0.323_f64.cos() - 1.5_f64.cos())).sqrt();
    /// assert!((pendulum.contact_speed()? - exact).abs() < 1e-14);
    /// # Ok::<(), lindstedt::impact::CollisionError>(())
    /// ```
    pub fn contact_speed(&self) -> Result<f64, CollisionError> {
        let &Collision { release, barrier, restoring_force, .. } = self;
        // The motion starts only if the force drives it; a force of the size of rounding means the
        // unstable equilibrium itself.
        let typical = (1..=16)
            .map(|part| {
                restoring_force(release + (barrier - release) * f64::from(part) / 16.0).abs()
            })
            .fold(0.0, f64::max);
        if restoring_force(release) > -1e-12 * typical {
            return Err(CollisionError::OutsideTheWell { release, at: release });
        }
        let parts = 32;
        let mut gained = 0.0;
        let mut from = release;
        for part in 1..=parts {
            let to = release + (barrier - release) * f64::from(part) / f64::from(parts);
            gained -= integrate_smooth(restoring_force, from, to, 1e-13)?.0;
            if gained <= 0.0 {
                return Err(CollisionError::OutsideTheWell { release, at: to });
            }
            from = to;
        }
        Ok((2.0 * gained).sqrt())
    }
}

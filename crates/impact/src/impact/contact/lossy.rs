//! The table of the laws of a contact that loses energy, by name: their closed forms, and the damping of a wanted
//! restitution.
//!
//! ```text
//! hunt-crossley          d'' = -gamma d^n (1 + lambda d')           e by lambda v
//! kelvin-voigt           d'' = -gamma (d + lambda d')               e by lambda sqrt(gamma), until d = 0
//! kelvin-voigt-no-pull   d'' = -gamma max(d + lambda d', 0)         e likewise
//! ```
//!
//! In: a law, the force, the damping and the speed of the touch, d(0) = 0, d'(0) = v. Out: a [`LossyContact`]. The
//! laws themselves are in `hunt_crossley` and `damped_spring`.

use super::hunt_crossley::{self, HuntCrossley};
use super::{ContactError, DampedSpring, Dashpot};

/// A law of a contact that loses energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LossyLaw {
    /// The law of Hunt and Crossley: the elastic force times 1 + lambda d'.
    HuntCrossley,
    /// A spring with a dashpot.
    Dashpot(Dashpot),
}

impl LossyLaw {
    /// Every law, in the order of a table.
    pub const ALL: [Self; 3] =
        [Self::HuntCrossley, Self::Dashpot(Dashpot::Pulls), Self::Dashpot(Dashpot::DoesNotPull)];

    /// The name in tables and problem files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::HuntCrossley => "hunt-crossley",
            Self::Dashpot(dashpot) => dashpot.name(),
        }
    }

    /// The law of this name; `None` if there is none.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|law| law.name() == name)
    }

    /// The dashpot; `None` for the law of Hunt and Crossley.
    pub const fn dashpot(self) -> Option<Dashpot> {
        match self {
            Self::HuntCrossley => None,
            Self::Dashpot(dashpot) => Some(dashpot),
        }
    }

    /// The damping lambda, time over the unit of x or, of a dashpot, time alone, with which a contact of this
    /// stiffness gamma, touched at this speed, has the coefficient of restitution.
    ///
    /// # Errors
    /// [`ContactError::Restitution`] for one that is not above 0 and at most 1.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::contact::{LossyContact, LossyLaw};
    ///
    /// for law in LossyLaw::ALL {
    ///     let damping = law.damping_for(0.7, 1e4, 2.0)?;
    ///     let contact = LossyContact::new(law, 1.0, 1e4, damping, 2.0)?;
    ///     assert!((contact.numbers().restitution - 0.7).abs() < 1e-12);
    /// }
    /// # Ok::<(), lindstedt::impact::contact::ContactError>(())
    /// ```
    pub fn damping_for(
        self,
        restitution: f64,
        stiffness: f64,
        speed: f64,
    ) -> Result<f64, ContactError> {
        match self {
            Self::HuntCrossley => Ok(hunt_crossley::damping_for(restitution)? / speed),
            Self::Dashpot(dashpot) => {
                Ok(2.0 * dashpot.damping_ratio_for(restitution)? / stiffness.sqrt())
            }
        }
    }
}

/// A contact that loses energy, in closed form, nothing else acting.
#[derive(Clone, Debug, PartialEq)]
pub enum LossyContact {
    /// By Hunt and Crossley.
    HuntCrossley(HuntCrossley),
    /// A spring with a dashpot.
    Dashpot(DampedSpring),
}

/// The numbers of a contact that loses energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LossyNumbers {
    /// The damping lambda, time over the unit of x or, of a dashpot, time alone.
    pub damping: f64,
    /// The greatest depth D, in the unit of x.
    pub depth: f64,
    /// The duration T, in the unit of time.
    pub duration: f64,
    /// The greatest force, per unit of mass.
    pub peak_force: f64,
    /// The depth at which the force is greatest.
    pub peak_depth: f64,
    /// The coefficient of restitution e, speed out over speed in.
    pub restitution: f64,
    /// The speed e v of release.
    pub exit_speed: f64,
    /// The energy lost, (1 - e^2) v^2/2, per unit of mass.
    pub energy_lost: f64,
}

impl LossyContact {
    /// The contact by a law, of the exponent n, 1 for a spring with a dashpot, stiffness gamma and damping lambda,
    /// touched at this speed.
    ///
    /// # Errors
    /// [`ContactError`]: a quantity outside its domain, another exponent than 1 beside a dashpot, a dashpot from
    /// which the motion does not come back, or numbers beyond double precision.
    pub fn new(
        law: LossyLaw,
        exponent: f64,
        stiffness: f64,
        damping: f64,
        speed: f64,
    ) -> Result<Self, ContactError> {
        match law {
            LossyLaw::HuntCrossley => {
                Ok(Self::HuntCrossley(HuntCrossley::new(exponent, stiffness, damping, speed)?))
            }
            LossyLaw::Dashpot(_) if (exponent - 1.0).abs() > 1e-9 => Err(ContactError::NoSpring),
            LossyLaw::Dashpot(dashpot) => {
                Ok(Self::Dashpot(DampedSpring::new(dashpot, stiffness, damping, speed)?))
            }
        }
    }

    /// The numbers of the contact.
    pub const fn numbers(&self) -> LossyNumbers {
        match self {
            Self::HuntCrossley(contact) => LossyNumbers {
                damping: contact.damping,
                depth: contact.depth,
                duration: contact.duration,
                peak_force: contact.peak_force,
                peak_depth: contact.peak_depth,
                restitution: contact.restitution,
                exit_speed: contact.exit_speed,
                energy_lost: contact.energy_lost,
            },
            Self::Dashpot(contact) => LossyNumbers {
                damping: contact.damping,
                depth: contact.depth,
                duration: contact.duration,
                peak_force: contact.peak_force,
                peak_depth: contact.peak_depth,
                restitution: contact.restitution,
                exit_speed: contact.exit_speed,
                energy_lost: contact.energy_lost,
            },
        }
    }

    /// The depth at a time since the touch, in the unit of x.
    pub fn position(&self, time: f64) -> f64 {
        match self {
            Self::HuntCrossley(contact) => contact.position(time),
            Self::Dashpot(contact) => contact.phase_point(time)[0],
        }
    }
}

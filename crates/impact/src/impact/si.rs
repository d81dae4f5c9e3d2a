//! The numbers of an impact in SI units, and the check whether a body yields.
//!
//! In: an [`Impact`] whose [`Setup`](super::Setup) has [`Units`]. Out: an [`SiImpact`], every
//! number by Runge-Kutta and by each closed form. The peak force is that of Hertz at the greatest
//! depth, also for a phase by a line; for a damped contact it is the greatest force, which occurs
//! before the greatest depth.

use super::closed_form::{Impact, ImpactQuantity};
use super::contact::hunt_crossley;
use super::hertz;
use super::units::{FIRST_YIELD, Units};

/// The numbers of an impact in SI units.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SiImpact {
    /// The units.
    pub units: Units,
    /// The stiffness k of the contact, N/m^(3/2).
    pub contact_stiffness: f64,
    /// Time from the release to the touch, s.
    pub time_to_contact: ImpactQuantity,
    /// The speed at the touch, m/s.
    pub speed: ImpactQuantity,
    /// The kinetic energy at the touch, J.
    pub energy: ImpactQuantity,
    /// The greatest depth, m.
    pub penetration: ImpactQuantity,
    /// Duration of the contact, s.
    pub duration: ImpactQuantity,
    /// Period from release to release, s.
    pub period: ImpactQuantity,
    /// The greatest force of the contact, its damping included, N; without damping that at the
    /// greatest depth.
    pub peak_force: ImpactQuantity,
    /// The pressure of Hertz in its middle at the greatest depth, Pa; `None` if the radius is not
    /// known.
    pub peak_pressure: Option<ImpactQuantity>,
}

/// A stated yield limit beside the pressure of the true motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct YieldCheck {
    /// `sphere` or `barrier`.
    pub body: &'static str,
    /// Its yield limit Y, Pa.
    pub limit: f64,
    /// The pressure at which it begins to yield, 1.6 Y, Pa.
    pub onset: f64,
    /// The peak pressure of the true motion, Pa.
    pub pressure: f64,
}

impl YieldCheck {
    /// Whether the body yields, so that the theory is outside its range.
    pub fn is_exceeded(&self) -> bool {
        self.pressure > self.onset
    }
}

impl Impact {
    /// The numbers in SI units; `None` if no units are known, or if a number is beyond the range of
    /// doubles.
    pub fn si(&self) -> Option<SiImpact> {
        let units = self.setup.units?;
        let gamma = self.setup.stiffness;
        let [time_to_contact, speed, penetration, duration, period] = self.quantities();
        let metres = |depth: f64| units.length * depth;
        let force = |depth: f64| units.force() * hertz::force(gamma, depth);
        let time = |time: f64| units.time() * time;
        let damped_force = |speed: f64| {
            let force = hunt_crossley::peak_force(1.5, gamma, self.damping, speed);
            force.map_or(f64::NAN, |force| units.force() * force)
        };
        let si = SiImpact {
            units,
            contact_stiffness: units.contact_stiffness(gamma),
            time_to_contact: converted("time to contact", &time_to_contact, time),
            speed: converted("speed", &speed, |speed| units.speed() * speed),
            energy: converted("energy at the touch", &speed, |speed| {
                units.energy() * speed * speed / 2.0
            }),
            penetration: converted("penetration", &penetration, metres),
            duration: converted("duration", &duration, time),
            period: converted("period", &period, time),
            peak_force: match self.setup.loss {
                None => converted("peak force", &penetration, force),
                Some(_) => ImpactQuantity {
                    name: "peak force",
                    runge_kutta: units.force() * self.greatest_force,
                    closed_forms: speed
                        .closed_forms
                        .iter()
                        .map(|speed| damped_force(*speed))
                        .collect(),
                },
            },
            peak_pressure: units.radius.map(|_| {
                let pressure =
                    |depth| units.pressure(force(depth), metres(depth)).unwrap_or(f64::NAN);
                converted("peak pressure", &penetration, pressure)
            }),
        };
        let known = si.rows().into_iter().map(|(row, _)| row.runge_kutta);
        let in_range = known.chain([si.contact_stiffness]).all(f64::is_normal);
        in_range.then_some(si)
    }
}

/// A number of every reading, converted.
fn converted(
    name: &'static str,
    quantity: &ImpactQuantity,
    convert: impl Fn(f64) -> f64,
) -> ImpactQuantity {
    ImpactQuantity {
        name,
        runge_kutta: convert(quantity.runge_kutta),
        closed_forms: quantity.closed_forms.iter().map(|value| convert(*value)).collect(),
    }
}

impl SiImpact {
    /// Every number with its unit.
    pub fn rows(&self) -> Vec<(&ImpactQuantity, &'static str)> {
        let rows = [
            (&self.time_to_contact, "s"),
            (&self.speed, "m/s"),
            (&self.energy, "J"),
            (&self.penetration, "m"),
            (&self.duration, "s"),
            (&self.period, "s"),
            (&self.peak_force, "N"),
        ];
        let pressure = self.peak_pressure.iter().map(|pressure| (pressure, "Pa"));
        rows.into_iter().chain(pressure).collect()
    }

    /// The stated yield limits beside the pressure of the true motion.
    pub fn yield_checks(&self) -> Vec<YieldCheck> {
        let Some(pressure) = &self.peak_pressure else {
            return vec![];
        };
        let limits = self.units.yield_limits();
        limits
            .map(|(body, limit)| YieldCheck {
                body,
                limit,
                onset: FIRST_YIELD * limit,
                pressure: pressure.runge_kutta,
            })
            .collect()
    }
}

/// The greatest value of a function that rises and then falls, by golden sections; after the fall it may be constant, as
/// the force of a barrier that has let go.
pub(super) fn greatest(function: impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> f64 {
    let part = 0.5 * (5.0_f64.sqrt() - 1.0);
    let mut best = 0.0_f64;
    // 0.618^60 = 3e-13 of the contact.
    for _ in 0..60 {
        let (left, right) = (to - part * (to - from), from + part * (to - from));
        let (at_left, at_right) = (function(left), function(right));
        best = best.max(at_left).max(at_right);
        match at_left >= at_right {
            true => to = right,
            false => from = left,
        }
    }
    best
}

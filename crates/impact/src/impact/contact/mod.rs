//! Laws of one contact, with a common interface: depth, duration, peak force, and the motion.
//!
//! ```text
//! d'' + a + k d + gamma F(d) = 0,   d(0) = 0, d'(0) = v > 0,   until d = 0 again
//! a = f(x_c), k = f'(x_c)           what else acts at the barrier: force at touch (the preload), and its slope
//! F(d) = d^n                        n = 3/2 for Hertz, 1 for a spring, 2 for a cone
//! ```
//!
//! In: gamma, v, the exponent or the force as a closure, a and k. Out: depth D, duration T, peak
//! force, the motion. Each file uses only those above it:
//!
//! - [`power_law`]: a = k = 0, by Gamma and incomplete beta functions; a and k as corrections in
//!   powers of them.
//! - `time`: the time along a motion whose speed is known at every place, and back.
//! - [`exact`]: any force as a closure, by energy and quadrature; the motion as a short series of
//!   sines.
//! - [`hunt_crossley`]: a contact that loses energy, gamma d^n (1 + lambda d'): restitution, loop
//!   of force and depth, duration.
//! - `dashpot`: a spring with a dashpot, or a force with one that comes in by a step: restitution and
//!   damping.
//! - `damped_spring`: the motion of a spring with a dashpot, a damped sine.
//! - `lossy`: the laws that lose energy, by name.
//! - `line`: a line in place of the force, equation (15), which the paper's phases use as well.
//! - `half_oscillation`: homotopy, iteration and the balance of harmonics.
//! - [`law`]: all laws by name, beside the exact one: [`comparison`].
//!
//! Depths are in the unit of x, rad for the pendulum, times in units of 1/omega, forces per unit of
//! mass: accelerations, rad omega^2.

use thiserror::Error;

use super::hertz::NotPositive;
use super::linearisation::LinearisationError;
use crate::decimal::decimal;
use crate::numeric::ode::quadrature::QuadratureError;
use crate::numeric::ode::root::RootError;

mod damped_spring;
mod dashpot;
pub mod exact;
mod half_oscillation;
pub mod hunt_crossley;
pub mod law;
pub(super) mod line;
mod lossy;
pub mod power_law;
mod time;

pub use damped_spring::DampedSpring;
pub use dashpot::{Dashpot, StepContact};
pub use exact::{ExactContact, SineSeries};
pub use hunt_crossley::HuntCrossley;
pub use law::{
    ContactErrors, ContactLaw, ContactMotion, ContactRow, Touch, UnknownContactLaw, comparison,
};
pub use lossy::{LossyContact, LossyLaw, LossyNumbers};
pub use power_law::{CorrectedPowerLaw, PowerLaw};

/// The reason why a contact cannot be computed.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum ContactError {
    /// A quantity outside its domain.
    #[error(transparent)]
    NotPositive(#[from] NotPositive),
    /// A quantity that is not a number.
    #[error("the {quantity} must be a finite number, not {value}")]
    NotFinite {
        /// The name of the quantity.
        quantity: &'static str,
        /// The value given.
        value: f64,
    },
    /// A result that double precision does not hold.
    #[error(
        "the {quantity} of this contact is beyond the range of double precision: measure length and time in units nearer to it"
    )]
    Range {
        /// The name of the quantity.
        quantity: &'static str,
    },
    /// A restitution outside its range.
    #[error(
        "the coefficient of restitution must lie above 0 and be at most 1, not {0}: 1 is a contact without loss"
    )]
    Restitution(f64),
    /// A damping below zero.
    #[error(
        "the {quantity} must be a number and not negative, not {value}: 0 is a contact without loss"
    )]
    Negative {
        /// The name of the quantity.
        quantity: &'static str,
        /// The value given.
        value: f64,
    },
    /// A correction of no order, or of so many orders that their terms are lost in rounding.
    #[error(
        "the correction has 1 to {highest} orders, not {order}: from there on the exact contact is the better answer"
    )]
    Order {
        /// The order asked for.
        order: u32,
        /// The highest there is.
        highest: u32,
    },
    /// The forces beside the contact force are not a small correction to it.
    #[error(
        "the force at touch and its slope are no small correction: the last terms of the series are {depth_error:.1e} of the depth \
         and {duration_error:.1e} of the duration; take the exact contact"
    )]
    NoCorrection {
        /// The last terms of the depth, relative.
        depth_error: f64,
        /// The last terms of the duration, relative.
        duration_error: f64,
    },
    /// The force does not turn the motion back.
    #[error(
        "the force in contact does not turn the motion back, searched to depth {searched:.2e}: it must be finite and push back \
         hard enough on the way"
    )]
    NeverTurns {
        /// The depth that the search reached.
        searched: f64,
    },
    /// The force has corners, jumps or waves on the way.
    #[error(
        "the force in contact is not smooth enough for its motion to be computed: integrate it step by step"
    )]
    NotSmooth,
    /// A damping that changes the speed too fast for the panels that resolve it.
    #[error(
        "the contact is damped so strongly, mu*v/gamma = {}, that nearly all of the speed is lost at once: integrate it step by step",
        decimal(*product)
    )]
    TooDamped {
        /// lambda v, the product of damping and speed.
        product: f64,
    },
    /// A law of a power of the depth, asked about another force.
    #[error(
        "the force of this contact is not given as a power of the depth: give its exponent, or take the exact contact"
    )]
    NoPowerLaw,
    /// A dashpot beside a force that is no spring.
    #[error(
        "a dashpot has a closed form beside a spring alone, the exponent 1: take hunt-crossley"
    )]
    NoSpring,
    /// A dashpot so strong that the motion creeps back and never leaves the contact.
    #[error(
        "the dashpot does not let the motion out again: its damping ratio lambda*sqrt(gamma)/2 is {}, and must be below 1",
        decimal(*damping_ratio)
    )]
    NeverLeaves {
        /// The damping ratio.
        damping_ratio: f64,
    },
    /// The perturbation or the balance has no oscillation at this speed.
    #[error(
        "no oscillation of this form begins with that speed: what acts beside the contact is too strong; take the exact contact"
    )]
    NotOscillating,
    /// The force has no line.
    #[error(transparent)]
    Linearisation(#[from] LinearisationError),
    /// An integral over the force failed.
    #[error("the force in contact cannot be integrated: {0}")]
    Quadrature(#[from] QuadratureError),
    /// The force has no finite value somewhere.
    #[error("the force in contact has no turning point: {0}")]
    Root(#[from] RootError),
}

/// The value, if it is a number.
fn finite(quantity: &'static str, value: f64) -> Result<f64, ContactError> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(ContactError::NotFinite { quantity, value }),
    }
}

/// The result, if double precision holds it with all its digits.
fn in_range(quantity: &'static str, value: f64) -> Result<f64, ContactError> {
    match value.is_normal() && value > 0.0 {
        true => Ok(value),
        false => Err(ContactError::Range { quantity }),
    }
}

fn not_negative(quantity: &'static str, value: f64) -> Result<f64, ContactError> {
    match value.is_finite() && value >= 0.0 {
        true => Ok(value),
        false => Err(ContactError::Negative { quantity, value }),
    }
}

/// A time limited to the contact, from the touch (also for NaN) to the release.
fn within(time: f64, duration: f64) -> f64 {
    if time > 0.0 { time.min(duration) } else { 0.0 }
}

/// Runge-Kutta on d'' = -force(d, d') from the touch to the release, or for this time: against
/// which the laws are tested. Its first event is the deepest point.
#[cfg(test)]
fn by_runge_kutta(
    force: impl Fn(f64, f64) -> f64,
    [speed, depth, time]: [f64; 3],
) -> crate::numeric::ode::Trajectory {
    use crate::numeric::ode::{Event, IntegrationOptions, State, integrate};
    let options = IntegrationOptions {
        absolute_tolerance: 1e-14 * depth,
        ..IntegrationOptions::with_tolerance(1e-13)
    };
    let events = [Event::record(|_, _, v| v), Event::stop(|_, d, _| d).falling()];
    let start = State { t: 0.0, x: 0.0, v: speed };
    integrate(|_, d, v| -force(d, v), start, time, &events, &options).expect("a path")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decimal::significant;
    use hunt_crossley::{damping_for, restitution};
    use power_law::duration_factor;

    const PAGE: &str = include_str!("../../../../../docs/contact.md");

    /// The lines of a table of the page: under this header, as long as there are columns.
    fn table(header: &str) -> Vec<&'static str> {
        let lines = PAGE.lines().skip_while(|line| *line != header).skip(2);
        lines.take_while(|line| line.starts_with('|')).collect()
    }

    fn assert_table(header: &str, rows: &[String]) {
        let computed = rows.join("\n");
        assert_eq!(table(header).join("\n"), computed, "under {header}:\n{computed}\n");
    }

    fn percent(part: f64) -> String {
        let text = format!("{:+.4}", 100.0 * part);
        if text.ends_with("0.0000") { "0".to_owned() } else { text }
    }

    fn row(cells: impl IntoIterator<Item = String>) -> String {
        format!("| {} |", cells.into_iter().collect::<Vec<_>>().join(" | "))
    }

    #[test]
    fn the_numbers_of_the_power_law_are_those_of_the_page() {
        let numbers = [("Hertz", "3/2", 1.5), ("cone", "2", 2.0), ("cube", "3", 3.0)];
        for (force, name, exponent) in numbers {
            let line = row([
                force.to_owned(),
                name.to_owned(),
                significant(duration_factor(exponent), 12),
            ]);
            assert!(PAGE.contains(&line), "{line}");
        }
    }

    #[test]
    fn the_corrections_are_those_of_the_page() {
        let header = "| gamma | T, power law | T, first order | its estimate | T, second order | its estimate | D, second order |";
        let rows = [1e8, 1e6, 1e4, 1e2].map(|stiffness| {
            let touch = Touch { stiffness, ..Touch::default() };
            let exact = touch.contact_by(ContactLaw::Exact).unwrap();
            let plain = PowerLaw::new(1.5, stiffness, touch.speed).unwrap();
            let preload = touch.barrier.sin();
            let [first, second] =
                [1, 2].map(|order| plain.corrected(preload, touch.slope, order).unwrap());
            let error = |duration: f64| percent(duration / exact.duration - 1.0);
            row([
                format!("{stiffness:.0e}"),
                error(plain.duration),
                error(first.duration),
                percent(first.duration_error).replace('+', ""),
                error(second.duration),
                percent(second.duration_error).replace('+', ""),
                percent(second.depth / exact.depth - 1.0),
            ])
        });
        assert_table(header, &rows);
    }

    #[test]
    fn the_sines_are_those_of_the_page() {
        let rows = [
            (hertz_stiffness(), Touch::default().speed),
            (1e3, Touch::default().speed),
            (1.0, 0.5),
        ]
        .map(|(stiffness, speed)| {
            let touch = Touch { stiffness, speed, ..Touch::default() };
            let contact = ExactContact::new(|d| touch.force(d), speed).unwrap();
            let (coarse, fine) = (contact.sine_series(1e-3), contact.sine_series(1e-6));
            row([
                format!("gamma {}, v = {}", significant(stiffness, 3), significant(speed, 5)),
                coarse.harmonics.len().to_string(),
                fine.harmonics.len().to_string(),
                format!("{:.1e}", fine.deviation),
            ])
        });
        assert_table(
            "| pendulum at a barrier | sines for 1e-3 of D | for 1e-6 | left of the second |",
            &rows,
        );
    }

    fn hertz_stiffness() -> f64 {
        super::super::hertz::DEFAULT_STIFFNESS
    }

    #[test]
    fn the_losses_are_those_of_the_page() {
        let plain = PowerLaw::new(1.5, 1e6, 1.0).unwrap();
        let rows = [0.01, 0.1, 0.3, 1.0, 3.0, 10.0].map(|x| {
            let contact = HuntCrossley::new(1.5, 1e6, x, 1.0).unwrap();
            row([
                significant(x, 2),
                format!("{:.6}", contact.restitution),
                format!("{:.6}", 1.0 - 2.0 / 3.0 * x),
                format!("{:.5}", contact.depth / plain.depth),
                format!("{:.5}", contact.duration / plain.duration),
                format!("{:.5}", contact.peak_force / plain.peak_force),
            ])
        });
        assert_table(
            "| lambda v | e | 1 - (2/3) lambda v | D/D0 | T/T0 | peak force/gamma D0^n |",
            &rows,
        );
        let rows = [0.99, 0.9, 0.7, 0.5, 0.3, 0.1].map(|e: f64| {
            let rules = [1.5 * (1.0 - e), 0.75 * (1.0 - e * e), 1.6 * (1.0 - e) / e];
            let reached = rules.map(|x| format!("{:.4}", restitution(x).unwrap()));
            row([significant(e, 2), format!("{:.5}", damping_for(e).unwrap())]
                .into_iter()
                .chain(reached))
        });
        assert_table(
            "| e wanted | lambda v | Hunt-Crossley | Lankarani-Nikravesh | Flores |",
            &rows,
        );
    }

    #[test]
    fn the_errors_of_the_laws_are_those_of_the_page() {
        let soft = Touch { stiffness: 1e3, ..Touch::default() };
        let alone =
            Touch { stiffness: 1e6, restoring_force: &|_| 0.0, slope: 0.0, ..Touch::default() };
        let rows = |touch: &Touch| -> Vec<String> {
            let line = |row_of: ContactRow| {
                let (_, errors) = row_of.outcome.unwrap();
                let numbers = [errors.duration, errors.depth, errors.peak_force];
                let motion = percent(errors.motion).replace('+', "");
                row([format!("`{}`", row_of.law)]
                    .into_iter()
                    .chain(numbers.map(percent))
                    .chain([motion]))
            };
            comparison(touch).unwrap().into_iter().map(line).collect()
        };
        let header = "| law | T | D | peak force | motion |";
        let (first, second) =
            PAGE.split_once("Errors in % for the paper's pendulum at a soft barrier").unwrap();
        for (part, touch) in [(first, &alone), (second, &soft)] {
            let lines = part.lines().skip_while(|line| *line != header).skip(2);
            let printed: Vec<&str> = lines.take_while(|line| line.starts_with('|')).collect();
            let computed = rows(touch).join("\n");
            assert_eq!(printed.join("\n"), computed, "{computed}\n");
        }
    }
}

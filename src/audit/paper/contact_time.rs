//! The contact time of the paper compared with that of every reading of the contact.

use crate::impact::{ImpactQuantity, SiImpact};

/// The contact time that the paper prints after its equation (15), in s: compared with, never
/// computed from.
pub const CONTACT_TIME: f64 = 9.258e-8;

/// The ratio of the contact time of every reading to the printed [`CONTACT_TIME`]; it would be one
/// if that were reproduced.
///
/// ```
/// use lindstedt::audit::paper::over_contact_time;
/// use lindstedt::impact::{Setup, solve};
/// use lindstedt::problem::Problem;
///
/// let file: Problem = "".parse()?;
/// let found = solve(Setup::try_from(&file)?)?;
/// let ratio = found.si().map(|si| over_contact_time(&si).runge_kutta);
/// assert!(ratio.is_some_and(|ratio| ratio > 1000.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn over_contact_time(si: &SiImpact) -> ImpactQuantity {
    let over = |time: f64| time / CONTACT_TIME;
    ImpactQuantity {
        name: "duration / printed",
        runge_kutta: over(si.duration.runge_kutta),
        closed_forms: si.duration.closed_forms.iter().copied().map(over).collect(),
    }
}

/// Whether a contact time with this ratio to the printed one is that one, within the tolerance.
pub fn is_reproduced(ratio: f64, tolerance: f64) -> bool {
    (ratio - 1.0).abs() <= tolerance
}

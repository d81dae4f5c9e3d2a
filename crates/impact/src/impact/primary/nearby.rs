//! How much a rest time by closed forms depends on what closed forms leave out.
//!
//! A flight or a contact in closed form is off by a part of 1e-6 to 1e-3. Where each of many impacts
//! decides when the next one is, such a part grows until the impacts are others: then the rest time is
//! that of another motion. Two starts beside the given one show it.

use super::{PrimaryCase, PrimaryError, PrimarySettings, simulate_primary};

/// The part by which the starts are smaller and larger.
pub const NEARBY: f64 = 3e-4;

/// The least and the greatest rest time of the main mass by closed forms, for the start of this case
/// and starts a part of [`NEARBY`] smaller and larger; `None` if one of them has none.
///
/// # Errors
/// As [`simulate_primary`].
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::Model;
/// use lindstedt::impact::primary::{Primary, PrimaryCase, PrimarySettings, nearby_rest_times};
///
/// // Without barriers nothing decides: the rest time is that of two damped modes.
/// let primary = Primary { mass: 20.0, stiffness: 50.0, damping: 0.6, force: 0.0, frequency: 0.0 };
/// let model = Model { left: None, right: None, zeta: 0.02, ..Model::default() };
/// let case = PrimaryCase { primary, model, start: [0.0, 0.0, 0.05, 0.0] };
/// let settings = PrimarySettings { duration: 300.0, ..PrimarySettings::default() };
/// let [least, greatest] = nearby_rest_times(case, &settings)?.ok_or("a rest")?;
/// assert!(greatest / least - 1.0 < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn nearby_rest_times(
    case: PrimaryCase,
    settings: &PrimarySettings,
) -> Result<Option<[f64; 2]>, PrimaryError> {
    let settings = PrimarySettings { chain: true, stop_at_rest: true, ..*settings };
    let mut range = [f64::INFINITY, 0.0_f64];
    for part in [1.0 - NEARBY, 1.0, 1.0 + NEARBY] {
        let start = case.start.map(|value| value * part);
        let Ok(rest) = simulate_primary(PrimaryCase { start, ..case }, &settings)?.rest_time()
        else {
            return Ok(None);
        };
        range = [range[0].min(rest), range[1].max(rest)];
    }
    Ok(Some(range))
}

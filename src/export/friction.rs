//! A study of friction as a table of comma-separated values, and as a picture.
//!
//! In: a [`FrictionStudy`]. Out: the rows of the paper's Table 1 with the computed ones; sgn and
//! arctangent near zero, and the two motions near rest. As text and LaTeX it is in
//! [`text`](super::text) and [`latex`](super::latex), as a document in `export::json`.

use std::fmt::Write as _;

use super::figure::{CurveStyle, FigureError, GuideLine, Points, curve, figure, panel};
use crate::audit::paper::FrictionTable;
use crate::decimal::decimal;
use crate::impact::friction::FrictionStudy;
use crate::impact::{Simulation, friction::arctangent};

/// The two laws at every speed, with the entries that the paper prints there; the first line is a
/// comment with the units.
///
/// ```
/// use lindstedt::impact::friction::{FrictionSetup, study};
///
/// let study = study(FrictionSetup { speeds: vec![0.01], ..FrictionSetup::default() })?;
/// let table = lindstedt::export::friction::csv(&study);
/// assert!(table.lines().last().is_some_and(|row| row.starts_with("0.01,1,0.5,50,")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn csv(study: &FrictionStudy) -> String {
    let mut text = String::from(
        "# units: speed rad*omega, sign 1, arctangent 1, error %, printed_value 1, printed_error %\n\
         speed,sign,arctangent,error,printed_value,printed_error\n",
    );
    for row in FrictionTable::from_study(study).rows {
        let laws = row.laws;
        let [value, error] =
            row.printed.map_or([""; 2], |entries| entries.map(|entry| entry.printed));
        let _ = writeln!(
            text,
            "{},{},{},{},{value},{error}",
            laws.speed, laws.sign, laws.arctangent, laws.error
        );
    }
    text
}

/// sgn and arctangent near zero; the two motions from the release near rest; the creep from where
/// Coulomb's law stops.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::impact::friction::{FrictionSetup, study};
///
/// let study = study(FrictionSetup::default())?;
/// assert!(lindstedt::export::friction::picture(&study)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn picture(study: &FrictionStudy) -> Result<String, FigureError> {
    const TIME: &str = "time t (units of 1/ω)";
    const PLACE: &str = "displacement x (rad)";
    /// Speeds of the first panel, on either side of zero.
    const NEAR_ZERO: f64 = 0.1;
    let near_rest = &study.near_rest;
    let (stop, creep) = (near_rest.stop, &near_rest.creep);
    let sign = [(-NEAR_ZERO, -1.0), (0.0, -1.0), (0.0, 1.0), (NEAR_ZERO, 1.0)];
    let smooth: Points = (-200..=200)
        .map(|index| NEAR_ZERO * f64::from(index) / 200.0)
        .map(|speed| (speed, arctangent(speed, std::f64::consts::PI)))
        .collect();
    let from = (stop.t - 10.0).max(0.0);
    let [coulomb, by_arctangent] = near_rest.motions.each_ref().map(|motion| points(motion, from));
    let crept = points(&creep.motion, 0.0);
    let held = [(0.0, stop.x), (creep.motion.end_time, stop.x)];
    let formula: Points =
        crept.iter().filter_map(|(t, _)| Some((*t, creep.formula(*t)?))).collect();
    let mut after = vec![
        curve("sgn", &held, CurveStyle::RUNGE_KUTTA),
        curve("arctangent", &crept, CurveStyle::DIFFERENCE),
    ];
    if formula.len() > 1 {
        after.push(curve("creep by formula", &formula, CurveStyle::FORMULA));
    }
    let pair = |first, second| {
        vec![
            curve("sgn", first, CurveStyle::RUNGE_KUTTA),
            curve("arctangent", second, CurveStyle::DIFFERENCE),
        ]
    };
    let zero = || vec![GuideLine::Y(0.0, "")];
    let panels = [
        panel(
            "Friction near zero speed",
            ["velocity x′", "friction / α"],
            pair(&sign, &smooth),
            Vec::new(),
        ),
        panel("Coming to rest", [TIME, PLACE], pair(&coulomb, &by_arctangent), zero()),
        panel("From rest where sgn holds it", [TIME, PLACE], after, zero()),
    ];
    let caption = format!(
        "Released from rest at x = {} with friction α = {}: by sgn(x′) it stops for good at t = {}, x = {}; by (2/π) atan(100 x′) never.",
        decimal(-study.setup.amplitude),
        decimal(study.setup.alpha),
        decimal(stop.t),
        decimal(stop.x)
    );
    figure(&panels, &caption)
}

/// The motion from a time on, at equal distances of time.
fn points(motion: &Simulation, from: f64) -> Points {
    const POINTS: usize = 800;
    let times =
        (0..=POINTS).map(|index| from + (motion.end_time - from) * (index as f64 / POINTS as f64));
    times.filter_map(|t| motion.path.phase_point_at(t).map(|(x, _)| (t, x))).collect()
}

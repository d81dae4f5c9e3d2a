//! A motion in numbers as comma-separated values and as a picture; text by [`text::document`](super::text::document).

use std::fmt::Write as _;

#[cfg(feature = "plot")]
use super::figure::{Curve, CurveStyle, FigureError, Panel, figure};
use crate::report::TrajectoryReport;
use crate::trajectory::in_words;

/// The points of a table or a curve where no samples are asked for.
const POINTS: u32 = 2000;

/// The times of a whole motion.
fn times(report: &TrajectoryReport) -> Vec<f64> {
    let end = report.motion.end();
    match report.samples.is_empty() {
        true => (0..=POINTS)
            .map(|point| end * f64::from(point) / f64::from(POINTS))
            .collect(),
        false => report.samples.to_vec(),
    }
}

/// Time, coordinates and velocities, 2001 times or those asked for.
///
/// ```
/// use lindstedt::Oscillator;
/// use lindstedt::report::TrajectoryReport;
/// use lindstedt::trajectory::Course;
///
/// let mut course = Course::of_equation(&Oscillator::parse("x'' + x = 0")?);
/// course.begin("x'".into(), 1.0)?;
/// let motion = course.follow()?;
/// let report = TrajectoryReport { motion: &motion, judge: None, samples: &[0.0] };
/// assert_eq!(lindstedt::export::trajectory::csv(&report), "t,x,x'\n0,0,1\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn csv(report: &TrajectoryReport) -> String {
    let motion = report.motion;
    let names: Vec<&str> = motion.course.rates.states.iter().map(|name| name.name()).collect();
    let mut text = format!("t,{}\n", names.join(","));
    for time in times(report) {
        if let Some(state) = motion.at(time) {
            let state: Vec<String> = state.iter().map(ToString::to_string).collect();
            let _ = writeln!(text, "{time},{}", state.join(","));
        }
    }
    if !motion.is_complete() {
        let _ = writeln!(text, "# incomplete: {}", in_words(motion.reason()));
    }
    text
}

/// Every coordinate in time, and its phase plane beside it.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::Oscillator;
/// use lindstedt::report::TrajectoryReport;
/// use lindstedt::trajectory::Course;
///
/// let mut course = Course::of_equation(&Oscillator::parse("x'' + x = 0")?);
/// course.begin("x".into(), 1.0)?;
/// let motion = course.follow()?;
/// let report = TrajectoryReport { motion: &motion, judge: None, samples: &[] };
/// assert!(lindstedt::export::trajectory::picture(&report)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[cfg(feature = "plot")]
pub fn picture(report: &TrajectoryReport) -> Result<String, FigureError> {
    let motion = report.motion;
    let course = &motion.course;
    let count = course.coordinates.len();
    let whole = TrajectoryReport {
        samples: &[],
        ..*report
    };
    let states: Vec<(f64, Vec<f64>)> = times(&whole)
        .into_iter()
        .filter_map(|time| Some((time, motion.at(time)?)))
        .collect();
    let in_time: Vec<Vec<(f64, f64)>> = (0..count)
        .map(|index| states.iter().map(|(time, state)| (*time, state[index])).collect())
        .collect();
    let planes: Vec<Vec<(f64, f64)>> = (0..count)
        .map(|index| {
            states
                .iter()
                .map(|(_, state)| (state[index], state[count + index]))
                .collect()
        })
        .collect();
    let names: Vec<[String; 2]> = course
        .coordinates
        .iter()
        .map(|name| [name.to_string(), format!("{name}′")])
        .collect();
    let mut panels = Vec::new();
    for (name, (in_time, plane)) in names.iter().zip(in_time.iter().zip(&planes)) {
        let panel = |title, x_label, y_label, points| Panel {
            title,
            x_label,
            y_label,
            curves: vec![Curve {
                label: "",
                points,
                style: CurveStyle::DIFFERENCE,
            }],
            ..Panel::default()
        };
        panels.push(panel("Motion", "time t", name[0].as_str(), in_time.as_slice()));
        panels.push(panel(
            "Phase plane",
            name[0].as_str(),
            name[1].as_str(),
            plane.as_slice(),
        ));
    }
    let equations: Vec<String> = course.equations.iter().map(|left| format!("{left} = 0")).collect();
    figure(&panels, &format!("{}.", equations.join(", ")))
}

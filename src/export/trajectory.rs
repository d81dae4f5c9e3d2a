//! A motion in numbers as comma-separated values and as a picture; text by
//! [`text::document`](super::text::document).

use super::csv::{end, line};
use super::figure::{CurveStyle, FigureError, Panel, Points, curve, figure, panel};
use crate::decimal::decimal;
use crate::report::{MotionSweep, TrajectoryReport};
use crate::report::{event_in_words, section_in_words, wall_in_words};
use crate::symbol::Symbol;
use crate::trajectory::in_words;
use crate::trajectory::{Crossing, PoincareSection, SweptMotion, Trajectory, TrajectoryRequest};

/// Number of points of a table or a curve if no samples are requested.
const POINTS: u32 = 2000;

/// The times of a whole motion.
fn times(report: &TrajectoryReport) -> Vec<f64> {
    let end = report.motion.end();
    match report.samples.is_empty() {
        true => (0..=POINTS).map(|point| end * f64::from(point) / f64::from(POINTS)).collect(),
        false => report.samples.to_vec(),
    }
}

/// Time, coordinates and velocities at 2001 instants or at the requested ones; with a section,
/// those of its states.
///
/// ```
/// use lindstedt::Oscillator;
/// use lindstedt::report::TrajectoryReport;
/// use lindstedt::trajectory::TrajectoryRequest;
///
/// let mut course = TrajectoryRequest::of_equation(&Oscillator::parse("x'' + x = 0")?);
/// course.begin("x'".into(), 1.0)?;
/// let motion = course.follow()?;
/// let report = TrajectoryReport { motion: &motion, judge: None, samples: &[0.0], known_until: None, lyapunov: None };
/// assert_eq!(lindstedt::export::trajectory::csv(&report), "t,x,x'\n0,0,1\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn csv(report: &TrajectoryReport) -> String {
    let motion = report.motion;
    let names = motion.course.rates.states.iter().map(|name| name.name());
    let mut text = line(std::iter::once("t").chain(names));
    let on_section = motion.course.section.is_some() && report.samples.is_empty();
    let times = match on_section {
        true => motion.crossings().iter().map(|crossing| crossing.time).collect(),
        false => times(report),
    };
    for time in times {
        let state = motion.states_at(time).into_iter();
        text.extend(state.map(|state| line(std::iter::once(time).chain(state))));
    }
    text + &end(motion.is_complete(), in_words(motion.reason()), report.doubt())
}

/// Every coordinate in time, and its phase plane beside it.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::Oscillator;
/// use lindstedt::report::TrajectoryReport;
/// use lindstedt::trajectory::TrajectoryRequest;
///
/// let mut course = TrajectoryRequest::of_equation(&Oscillator::parse("x'' + x = 0")?);
/// course.begin("x".into(), 1.0)?;
/// let motion = course.follow()?;
/// let report = TrajectoryReport { motion: &motion, judge: None, samples: &[], known_until: None, lyapunov: None };
/// assert!(lindstedt::export::trajectory::picture(&report)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn picture(report: &TrajectoryReport) -> Result<String, FigureError> {
    let motion = report.motion;
    let course = &motion.course;
    let count = course.coordinates.len();
    if let Some(section) = &course.section {
        return on_section(motion, section);
    }
    let whole = TrajectoryReport { samples: &[], ..*report };
    let mut states: Vec<(f64, Vec<f64>)> = times(&whole)
        .into_iter()
        .filter_map(|time| Some((time, motion.states_at(time)?)))
        .collect();
    // States jump at impacts and events: both sides of them are drawn.
    let impacts = motion.walls.impacts.iter().map(|impact| impact.time);
    let mut jumps: Vec<f64> =
        impacts.chain(motion.events.occurrences.iter().map(|event| event.time)).collect();
    jumps.sort_by(f64::total_cmp);
    jumps.dedup();
    for time in jumps {
        let sides = [motion.states_at(time), motion.states_after(time)];
        states.extend(sides.into_iter().flatten().map(|state| (time, state)));
    }
    states.sort_by(|one, other| one.0.total_cmp(&other.0));
    let in_time: Vec<Points> = (0..count)
        .map(|index| states.iter().map(|(time, state)| (*time, state[index])).collect())
        .collect();
    let planes: Vec<Points> = (0..count)
        .map(|index| states.iter().map(|(_, state)| (state[index], state[count + index])).collect())
        .collect();
    let names: Vec<[String; 2]> =
        course.coordinates.iter().map(|name| [name.to_string(), format!("{name}′")]).collect();
    let mut panels = Vec::new();
    for (name, (in_time, plane)) in names.iter().zip(in_time.iter().zip(&planes)) {
        let line = |points| vec![curve("", points, CurveStyle::DIFFERENCE)];
        panels.push(panel("Motion", ["time t", &name[0]], line(in_time), vec![]));
        panels.push(panel("Phase plane", [&name[0], &name[1]], line(plane), vec![]));
    }
    figure(&panels, &format!("{}.", equations_in_words(course)))
}

/// The equations, the walls and the events of a problem, in words.
fn equations_in_words(course: &TrajectoryRequest) -> String {
    let equations = course.equations.iter().map(|left| format!("{left} = 0"));
    let several = course.walls.len() > 1;
    let walls = course.walls.iter().enumerate();
    let walls = walls.map(|(index, wall)| wall_in_words(index, wall, several));
    let several = course.events.len() > 1;
    let events = course.events.iter().enumerate();
    let events = events.map(|(index, event)| event_in_words(index, event, several));
    equations.chain(walls).chain(events).collect::<Vec<String>>().join(", ")
}

/// The states on a section: each coordinate with its velocity.
fn on_section(motion: &Trajectory, section: &PoincareSection) -> Result<String, FigureError> {
    let course = &motion.course;
    let count = course.coordinates.len();
    let names: Vec<[String; 2]> =
        course.coordinates.iter().map(|name| [name.to_string(), format!("{name}′")]).collect();
    // At impacts the places are those of the walls: velocities are drawn over the time.
    let at_impacts = *section == PoincareSection::Impacts;
    let point = |index: usize| {
        move |crossing: &Crossing| {
            let across = if at_impacts { crossing.time } else { crossing.state[index] };
            (across, crossing.state[count + index])
        }
    };
    let points: Vec<Points> =
        (0..count).map(|index| motion.crossings().iter().map(point(index)).collect()).collect();
    let panels: Vec<Panel> = names
        .iter()
        .zip(&points)
        .map(|(name, points)| match at_impacts {
            true => dots("Velocity before each impact", ["time t", &name[1]], points),
            false => dots("Poincaré section", [&name[0], &name[1]], points),
        })
        .collect();
    figure(&panels, &format!("{}. {}", equations_in_words(course), section_in_words(section)))
}

fn dots<'a>(title: &'a str, labels: [&'a str; 2], points: &'a [(f64, f64)]) -> Panel<'a> {
    panel(title, labels, vec![curve("", points, CurveStyle::DOTS)], vec![])
}

/// Many motions: a line for every state on the section, or without a section one for every motion
/// with its extremes.
pub fn sweep_csv(sweep: &MotionSweep) -> String {
    let course = sweep.course;
    let named = |name: &Symbol| name.name().to_owned();
    let varied = sweep.names.iter().map(named);
    let states = course.rates.states.iter().map(named);
    match course.section.is_some() {
        true => {
            let rows = sweep.motions.iter().flat_map(|motion| {
                motion.crossings.iter().map(|crossing| {
                    line(motion.values.iter().chain([&crossing.time]).chain(&crossing.state))
                })
            });
            line(varied.chain(["t".to_owned()]).chain(states)) + &rows.collect::<String>()
        }
        false => {
            let extremes = course
                .coordinates
                .iter()
                .flat_map(|name| [format!("least {name}"), format!("greatest {name}")]);
            let rows = sweep.motions.iter().map(|motion| {
                let cells = motion.values.iter().chain(motion.extremes.iter().flatten());
                line(cells.chain([&motion.end]).chain(&motion.state))
            });
            line(varied.chain(extremes).chain(["end".to_owned()]).chain(states))
                + &rows.collect::<String>()
        }
    }
}

/// The picture of a sweep over the varied parameter: every state on the section, a bifurcation
/// diagram; without a section the least and the greatest values.
///
/// # Errors
/// As [`figure`].
pub fn sweep_picture(sweep: &MotionSweep) -> Result<String, FigureError> {
    let course = sweep.course;
    let varied = sweep.names.first().map_or("", |name| name.name());
    let count = course.coordinates.len();
    // At impacts the places are those of the walls: velocities are drawn.
    let at_impacts = course.section == Some(PoincareSection::Impacts);
    let points: Vec<Points> = (0..count)
        .map(|index| {
            let shown = if at_impacts { count + index } else { index };
            let of = |motion: &SweptMotion| -> Points {
                let value = motion.values.first().copied().unwrap_or(f64::NAN);
                match course.section.is_some() {
                    true => motion
                        .crossings
                        .iter()
                        .map(|crossing| (value, crossing.state[shown]))
                        .collect(),
                    false => {
                        motion.extremes[index].iter().map(|extreme| (value, *extreme)).collect()
                    }
                }
            };
            sweep.motions.iter().flat_map(of).collect()
        })
        .collect();
    let name = |name: &Symbol| if at_impacts { format!("{name}′") } else { name.to_string() };
    let names: Vec<String> = course.coordinates.iter().map(name).collect();
    let title = match course.section.is_some() {
        true if at_impacts => "Velocity before each impact",
        true => "States on the section",
        false => "Least and greatest values",
    };
    let panels: Vec<Panel> = names
        .iter()
        .zip(&points)
        .map(|(name, points)| dots(title, [varied, name], points))
        .collect();
    let equations = equations_in_words(course);
    let section = course.section.as_ref().map(|section| format!(". {}", section_in_words(section)));
    let after = match course.after > 0.0 {
        true => format!(", from t = {} to {}", decimal(course.after), decimal(course.duration)),
        false => format!(", to t = {}", decimal(course.duration)),
    };
    figure(&panels, &format!("{equations}{}{after}", section.unwrap_or_default()))
}

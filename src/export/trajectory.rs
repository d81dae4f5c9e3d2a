//! A motion in numbers as comma-separated values and as a picture; text by
//! [`text::document`](super::text::document).

use super::csv::{end, line};
use super::figure::{CurveStyle, FigureError, Panel, Points, curve, figure, panel};
use crate::decimal::decimal;
use crate::report::{BasinSweep, MotionSweep, TrajectoryReport};
use crate::report::{event_in_words, section_in_words, wall_in_words};
use crate::symbol::Symbol;
use crate::trajectory::in_words;
use crate::trajectory::{Fate, PoincareSection, SweptMotion, Trajectory, TrajectoryRequest};

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
    let column = |index: usize| states.iter().map(move |(_, state)| state[index]);
    let times = || states.iter().map(|(time, _)| *time);
    let in_time: Vec<Points> =
        (0..count).map(|index| times().zip(column(index)).collect()).collect();
    let planes = planes(course);
    let in_plane: Vec<Points> = planes
        .iter()
        .map(|plane| column(plane.states[0]).zip(column(plane.states[1])).collect())
        .collect();
    let line = |points| vec![curve("", points, CurveStyle::DIFFERENCE)];
    let mut panels = Vec::new();
    for (index, (name, points)) in course.coordinates.iter().zip(&in_time).enumerate() {
        panels.push(panel("Motion", ["time t", name.name()], line(points), vec![]));
        let own = planes.iter().zip(&in_plane).filter(|(plane, _)| plane.states[0] == index);
        for (plane, points) in own {
            let [across, up] = &plane.names;
            panels.push(panel("Phase plane", [across, up], line(points), vec![]));
        }
    }
    figure(&panels, &format!("{}.", equations_in_words(course)))
}

/// Two states that are drawn over each other.
struct Plane {
    states: [usize; 2],
    names: [String; 2],
}

/// Each coordinate with its velocity, and each coordinate of an equation of first order with the next one.
fn planes(course: &TrajectoryRequest) -> Vec<Plane> {
    let coordinates = &course.coordinates;
    let is_first_order = |index: &usize| velocity_of(course, *index).is_none();
    let of_first_order: Vec<usize> = (0..coordinates.len()).filter(is_first_order).collect();
    let beside = of_first_order.windows(2).map(|pair| Plane {
        states: [pair[0], pair[1]],
        names: [pair[0], pair[1]].map(|index| coordinates[index].to_string()),
    });
    let with_velocity = coordinates.iter().enumerate().filter_map(|(index, name)| {
        let velocity = velocity_of(course, index)?;
        Some(Plane { states: [index, velocity], names: [name.to_string(), format!("{name}′")] })
    });
    with_velocity.chain(beside).collect()
}

/// The place of the velocity of a coordinate among the states; `None` for an equation of first order.
fn velocity_of(course: &TrajectoryRequest, coordinate: usize) -> Option<usize> {
    let velocity = course.coordinates[coordinate].derivative();
    course.rates.states.iter().position(|state| *state == velocity)
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

/// The states on a section: each coordinate with its velocity, those of equations of first order with each
/// other, and a single one of these over the time.
fn on_section(motion: &Trajectory, section: &PoincareSection) -> Result<String, FigureError> {
    let course = &motion.course;
    let crossings = motion.crossings();
    let column = |index: usize| crossings.iter().map(move |crossing| crossing.state[index]);
    let over_time = |index: usize| -> Points {
        crossings.iter().map(|crossing| crossing.time).zip(column(index)).collect()
    };
    // At impacts the places are those of the walls: velocities are drawn over the time.
    let drawn: Vec<([String; 2], Points)> = match (section, planes(course).as_slice()) {
        (PoincareSection::Impacts, planes) => planes
            .iter()
            .map(|plane| (["time t".to_owned(), plane.names[1].clone()], plane.states[1]))
            .map(|(names, state)| (names, over_time(state)))
            .collect(),
        (_, []) => (course.coordinates.iter().enumerate())
            .map(|(index, name)| (["time t".to_owned(), name.to_string()], over_time(index)))
            .collect(),
        (_, planes) => planes
            .iter()
            .map(|plane| {
                let [across, up] = plane.states;
                (plane.names.clone(), column(across).zip(column(up)).collect())
            })
            .collect(),
    };
    let title = match section {
        PoincareSection::Impacts => "Velocity before each impact",
        _ => "Poincaré section",
    };
    let panels: Vec<Panel> =
        drawn.iter().map(|([across, up], points)| dots(title, [across, up], points)).collect();
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
/// diagram; without a section the least and the greatest values; of starts in a plane the basins of the
/// attractors.
///
/// # Errors
/// As [`figure`].
pub fn sweep_picture(sweep: &MotionSweep) -> Result<String, FigureError> {
    let course = sweep.course;
    if let (Some(basins), &[across, up]) = (sweep.basins(), sweep.names) {
        let starts: Vec<Vec<f64>> =
            sweep.motions.iter().map(|motion| motion.values.clone()).collect();
        return basins_picture(&BasinSweep {
            course,
            names: [across, up],
            starts: &starts,
            basins: &basins,
        });
    }
    let varied = sweep.names.first().map_or("", |name| name.name());
    // At impacts the places are those of the walls: velocities are drawn.
    let at_impacts = course.section == Some(PoincareSection::Impacts);
    let coordinates = 0..course.coordinates.len();
    let shown: Vec<(usize, usize)> = match at_impacts {
        true => {
            coordinates.filter_map(|index| Some((index, velocity_of(course, index)?))).collect()
        }
        false => coordinates.map(|index| (index, index)).collect(),
    };
    let points: Vec<Points> = shown
        .iter()
        .map(|&(index, shown)| {
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
    let prime = if at_impacts { "′" } else { "" };
    let names = shown.iter().map(|(index, _)| format!("{}{prime}", course.coordinates[*index]));
    let names: Vec<String> = names.collect();
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
    figure(&panels, &sweep_in_words(course))
}

/// The starts in a plane, each in the colour of the attractor on which its motion settles, with the states of
/// the attractors.
///
/// # Errors
/// As [`figure`].
pub fn basins_picture(sweep: &BasinSweep) -> Result<String, FigureError> {
    let &BasinSweep { course, names: [across, up], starts, basins } = sweep;
    /// Width of the axes, of which the columns take the part that the margins leave.
    const WIDTH: f64 = 790.0 / 1.1;
    let columns = starts.chunk_by(|one, other| one[0] == other[0]).count();
    let width = WIDTH / columns.saturating_sub(1).max(1) as f64;
    let last = CurveStyle::REGIONS;
    let look = |fate: Fate| match fate {
        Fate::Settled(index) if index < last => {
            let states = basins.attractors[index].states.len();
            let states = if states == 1 { String::new() } else { format!(", {states} states") };
            (format!("attractor {}{states}", index + 1), CurveStyle::region(index, width))
        }
        Fate::Settled(_) => ("other attractors".to_owned(), CurveStyle::region(last, width)),
        Fate::Unsettled => ("does not settle".to_owned(), CurveStyle::no_region(width)),
        Fate::Ended => ("ends early".to_owned(), CurveStyle::outside(width)),
    };
    let mut bars: Vec<(Fate, Points)> = Vec::new();
    let fated: Vec<(&Vec<f64>, Fate)> = starts.iter().zip(basins.fates.iter().copied()).collect();
    for column in fated.chunk_by(|one, other| one.0[0] == other.0[0]) {
        // Each start stands for the places up to the middle between it and the next one.
        let height = |index: usize| column[index].0[1];
        let middle = |index: usize| 0.5 * (height(index) + height(index - 1));
        let end = column.len() - 1;
        let mut index = 0;
        for run in column.chunk_by(|one, other| one.1 == other.1) {
            let (first, next) = (index, index + run.len());
            let low = if first == 0 { height(0) } else { middle(first) };
            let high = if next > end { height(end) } else { middle(next) };
            bars.push((run[0].1, [low, high].map(|y| (column[0].0[0], y)).into()));
            index = next;
        }
    }
    let order = |fate: Fate| match fate {
        Fate::Settled(index) => index,
        Fate::Unsettled => usize::MAX - 1,
        Fate::Ended => usize::MAX,
    };
    bars.sort_by_key(|(fate, _)| order(*fate));
    let states = &course.rates.states;
    let place = |name: Symbol| states.iter().position(|state| *state == name).unwrap_or(0);
    let of_attractors = basins.attractors.iter().flat_map(|attractor| &attractor.states);
    // States outside of the plane of the starts would stretch it.
    let within = |index: usize, value: f64| {
        let values = || starts.iter().map(|start| start[index]);
        (values().fold(f64::INFINITY, f64::min)..=values().fold(f64::NEG_INFINITY, f64::max))
            .contains(&value)
    };
    let of_attractors: Points = of_attractors
        .map(|state| (state[place(across)], state[place(up)]))
        .filter(|(x, y)| within(0, *x) && within(1, *y))
        .collect();
    let drawn: Vec<(String, &Points, CurveStyle)> = bars
        .iter()
        .map(|(fate, points)| {
            let (label, style) = look(*fate);
            (label, points, style)
        })
        .collect();
    let mut curves: Vec<_> =
        drawn.iter().map(|(label, points, style)| curve(label, points, *style)).collect();
    if !of_attractors.is_empty() {
        let marks = CurveStyle::SECOND_MARKED_POINTS;
        curves.push(curve("states of the attractors", &of_attractors, marks));
    }
    let labels = [across, up].map(|name| name.name().replace('\'', "′"));
    let panels = [panel("Basins of attraction", [&labels[0], &labels[1]], curves, vec![])];
    figure(&panels, &sweep_in_words(course))
}

/// The equations of many motions, the section and the times, in words.
fn sweep_in_words(course: &TrajectoryRequest) -> String {
    let equations = equations_in_words(course);
    let section = course.section.as_ref().map(|section| format!(". {}", section_in_words(section)));
    let after = match course.after > 0.0 {
        true => format!(", from t = {} to {}", decimal(course.after), decimal(course.duration)),
        false => format!(", to t = {}", decimal(course.duration)),
    };
    format!("{equations}{}{after}", section.unwrap_or_default())
}

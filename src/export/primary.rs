//! The main mass with its damper as comma-separated values and as a picture; text by
//! [`text::document`](super::text::document).

use super::csv::{cell, end, head, line};
use super::figure::{
    CurveStyle, FigureError, GuideLine, Panel, Points, Scale, curve, figure, panel,
};
use crate::decimal::decimal;
use crate::impact::Units;
use crate::impact::primary::{Alone, PrimaryParameter};
use crate::impact::primary::{PrimaryRow, PrimaryStop, UndampedAndLocked};
use crate::impact::sweep::Spacing;
use crate::report::{PrimaryReport, PrimarySweepReport};

/// Number of points of a curve.
const POINTS: u32 = 2000;

/// Number of swings of the locked main mass that are drawn large.
const FIRST_SWINGS: f64 = 6.0;

/// The times of a table: those requested, or equal steps and every touch and release.
fn times(report: &PrimaryReport) -> Vec<f64> {
    if !report.samples.is_empty() {
        return report.samples.to_vec();
    }
    let end = report.motion.end;
    let even = (0..=POINTS).map(|point| end * f64::from(point) / f64::from(POINTS));
    let mut times: Vec<f64> = even.chain(report.motion.phase_starts()).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// Time, angle and its velocity, displacement of the main mass and its velocity, and the energy of
/// both.
///
/// ```
/// use lindstedt::impact::primary::simulate_primary;
/// use lindstedt::problem::Problem;
/// use lindstedt::report::PrimaryReport;
///
/// let file: Problem = "[primary]\nmass = 0.56\nstiffness = 80\ndisplacement = 0.02\n[run]\nduration = 20".parse()?;
/// let asked = file.primary_case(&[])?;
/// let motion = simulate_primary(asked.case, &asked.settings)?;
/// let table = lindstedt::export::primary::csv(&PrimaryReport { motion: &motion, units: &asked.units, samples: &[1.0], judge: None, nearby: None });
/// assert_eq!(table.lines().count(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn csv(report: &PrimaryReport) -> String {
    let motion = report.motion;
    let mut text = String::from(
        "# units: t 1/omega, x rad, velocity omega, y L, speed L*omega, energy m*g*L\nt,x,velocity,y,speed,energy\n",
    );
    for t in times(report) {
        text.extend(motion.state_at(t).map(|state| {
            let energy = motion.case.energy(state);
            line([t, state.x, state.velocity, state.y, state.speed, energy])
        }));
    }
    text + &end(motion.is_complete(), motion.stop, report.doubt())
}

/// A row for every motion of a sweep: the swept values, in their own units, then the results, which
/// are empty for a motion that was not begun.
///
/// ```
/// use lindstedt::report::PrimarySweepReport;
///
/// let report = PrimarySweepReport { axes: &[], parameters: &["frequency".parse()?], rows: &[], units: &[] };
/// assert!(lindstedt::export::primary::sweep_csv(&report).starts_with("# units: frequency rad/s, "));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep_csv(report: &PrimarySweepReport) -> String {
    const RESULTS: [(&str, &str); 11] = [
        ("amplitude", "L"),
        ("locked", "L"),
        ("without", "L"),
        ("impacts", "1"),
        ("rest_time", "1/omega"),
        ("rest_locked", "1/omega"),
        ("rest_without", "1/omega"),
        ("all_impacts", "1"),
        ("time_unit", "s"),
        ("length_unit", "m"),
        ("complete", "-"),
    ];
    let swept = report.parameters.iter().map(|parameter| match parameter.unit() {
        "" => (parameter.name(), "1"),
        unit => (parameter.name(), unit),
    });
    let columns: Vec<(&str, &str)> = swept.chain(RESULTS).collect();
    let mut text = head(&columns);
    for (number, (row, units)) in report.rows.iter().zip(report.units).enumerate() {
        let count = |count: usize| cell(row.is_begun().then_some(count));
        let UndampedAndLocked { locked, without } = row.others;
        let mut cells: Vec<String> = report.values(number).iter().map(f64::to_string).collect();
        let amplitude = row.is_begun().then_some(row.amplitude);
        cells.extend([amplitude, locked.amplitude, without.amplitude].map(cell));
        cells.push(count(row.impacts));
        cells.extend([rest_time(row), locked.rest_time, without.rest_time].map(cell));
        cells.extend([count(row.all_impacts), units.time().to_string(), units.length.to_string()]);
        cells.push((row.stop == PrimaryStop::Duration).to_string());
        text += &line(cells);
    }
    text
}

/// The rest time of a motion without a drive; `None` for a driven one or one that does not rest.
pub(super) fn rest_time(row: &PrimaryRow) -> Option<f64> {
    row.rest_time.ok().filter(|_| !row.is_driven())
}

/// The main mass with its damper, locked and without; the pendulum between its barriers.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::impact::primary::simulate_primary;
/// use lindstedt::problem::Problem;
/// use lindstedt::report::PrimaryReport;
///
/// let file: Problem = "[primary]\nmass = 0.56\nstiffness = 80\ndisplacement = 0.02\n[run]\nduration = 20".parse()?;
/// let asked = file.primary_case(&[])?;
/// let motion = simulate_primary(asked.case, &asked.settings)?;
/// let report = PrimaryReport { motion: &motion, units: &asked.units, samples: &[], judge: None, nearby: None };
/// assert!(lindstedt::export::primary::picture(&report)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn picture(report: &PrimaryReport) -> Result<String, FigureError> {
    let motion = report.motion;
    let (second, metre) = (report.units.time(), report.units.length);
    let all = PrimaryReport { samples: &[], ..*report };
    let states: Vec<_> =
        times(&all).into_iter().filter_map(|t| Some((t, motion.state_at(t)?))).collect();
    let with: Points = states.iter().map(|(t, state)| (t * second, state.y * metre)).collect();
    let angle: Points = states.iter().map(|(t, state)| (t * second, state.x)).collect();
    let energy: Points =
        states.iter().map(|(t, state)| (t * second, motion.case.energy(*state))).collect();
    let [locked, without] = [motion.case.primary.mass + 1.0, motion.case.primary.mass];
    // The first swings are drawn completely, and of all swings the decay.
    let first: Vec<f64> = states
        .iter()
        .map(|(t, _)| *t)
        .take_while(|t| {
            *t <= FIRST_SWINGS
                * std::f64::consts::TAU
                * (locked / motion.case.primary.stiffness).sqrt()
        })
        .collect();
    let early: Points = with.iter().take(first.len()).copied().collect();
    let [locked_swings, swings_without] =
        [locked, without].map(|mass| swings_alone(report, mass, &first));
    let some_times: Vec<f64> = states.iter().step_by(10).map(|(t, _)| *t).collect();
    let [locked_decay, decay_without] =
        [locked, without].map(|mass| decay_alone(report, mass, &some_times));
    let own = |points| curve("with its damper", points, CurveStyle::DIFFERENCE);
    let (mut all, mut some) = (vec![own(&with)], vec![own(&early)]);
    // With a drive the closed forms hold only in the long run.
    if motion.case.primary.force == 0.0 {
        some.insert(0, curve("without", &swings_without, CurveStyle::RUNGE_KUTTA));
        some.insert(1, curve("damper locked", &locked_swings, CurveStyle::SECOND_FORMULA));
        if let (Some(locked), Some(without)) = (&locked_decay, &decay_without) {
            all.push(curve("without", without, CurveStyle::RUNGE_KUTTA));
            all.push(curve("damper locked", locked, CurveStyle::SECOND_FORMULA));
        }
    }
    let barriers = [motion.case.model.left, motion.case.model.right].into_iter().flatten();
    let barriers = barriers.map(|place| GuideLine::Y(place, "barrier")).collect();
    const TIME: &str = "time t (s)";
    const PLACE: &str = "displacement y (m)";
    let panel = |title, y_label, curves, guides| panel(title, [TIME, y_label], curves, guides);
    let panels = [
        panel("Main mass, first swings", PLACE, some, vec![]),
        panel("Main mass", PLACE, all, vec![]),
        panel(
            "Pendulum",
            "angle x (rad)",
            vec![curve("pendulum", &angle, CurveStyle::THIRD_FORMULA)],
            barriers,
        ),
        panel(
            "Energy of both",
            "energy (m g L)",
            vec![curve("energy", &energy, CurveStyle::THIRD_FORMULA)],
            vec![],
        ),
    ];
    let caption = format!(
        "Main mass {} times the pendulum, its own frequency {} times that of the pendulum; {} impact{}.",
        decimal(motion.case.primary.mass),
        decimal((motion.case.primary.stiffness / motion.case.primary.mass).sqrt()),
        motion.impacts.len(),
        if motion.impacts.len() == 1 { "" } else { "s" }
    );
    figure(&panels, &caption)
}

/// The swings of the main mass without a pendulum, `mass` in all, at these times, in SI units.
fn swings_alone(report: &PrimaryReport, mass: f64, times: &[f64]) -> Points {
    let (case, units) = (&report.motion.case, report.units);
    let [.., y, speed] = case.start;
    let height = |t: f64| case.primary.alone_at(mass, [y, speed], t) * units.length;
    times.iter().map(|t| (t * units.time(), height(*t))).collect()
}

/// The amplitude of these swings; `None` if the mass is overdamped.
fn decay_alone(report: &PrimaryReport, mass: f64, times: &[f64]) -> Option<Points> {
    let (case, units) = (&report.motion.case, report.units);
    let [.., y, speed] = case.start;
    let points = times.iter().map(|t| {
        let height = case.primary.alone_envelope(mass, [y, speed], *t)?;
        Some((t * units.time(), height * units.length))
    });
    points.collect()
}

/// The amplitude of the main mass in the long run, or its rest time without a drive, over the
/// values of one parameter.
///
/// # Errors
/// More than one parameter, or as [`figure`].
///
/// ```
/// use lindstedt::impact::primary::sweep_primary;
/// use lindstedt::impact::sweep::Axis;
/// use lindstedt::problem::Problem;
/// use lindstedt::report::PrimarySweepReport;
///
/// let file: Problem = "[primary]\nmass = 0.56\nstiffness = 80\nforce = 0.01\ndamping = 0.5\n[run]\nduration = 20".parse()?;
/// let (axis, parameter): (Axis, _) = ("frequency=9:11:2".parse()?, "frequency".parse()?);
/// let asked: Result<Vec<_>, _> = axis.values().iter().map(|value| file.primary_case(&[(parameter, *value)])).collect();
/// let (motions, units): (Vec<_>, Vec<_>) = asked?.into_iter().map(|asked| ((asked.case, asked.settings), asked.units)).unzip();
/// let rows = sweep_primary(&motions, |_| ()).map_err(|(_, error)| error)?;
/// let report = PrimarySweepReport { axes: &[axis], parameters: &[parameter], rows: &rows, units: &units };
/// assert!(lindstedt::export::primary::sweep_picture(&report)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep_picture(report: &PrimarySweepReport) -> Result<String, FigureError> {
    let ([axis], [parameter]) = (report.axes, report.parameters) else {
        return Err(FigureError::Empty("the sweep".to_owned()));
    };
    let driven = report.is_driven();
    let points = |value: &dyn Fn(&PrimaryRow, &Units) -> Option<f64>| -> Points {
        let rows = axis.values().iter().zip(report.rows.iter().zip(report.units));
        let mut points: Points =
            rows.filter_map(|(place, (row, units))| Some((*place, value(row, units)?))).collect();
        // The values of a list need not be sorted, those of a curve must be.
        points.sort_by(|one, other| one.0.total_cmp(&other.0));
        points
    };
    let alone = |of: fn(&UndampedAndLocked) -> Alone| {
        points(&|row, units| match driven {
            true => Some(of(&row.others).amplitude? * units.length),
            false => Some(of(&row.others).rest_time? * units.time()),
        })
    };
    let with = points(&|row, units| match driven {
        true => row.is_begun().then_some(row.amplitude * units.length),
        false => Some(rest_time(row)? * units.time()),
    });
    let (locked, without) = (alone(|others| others.locked), alone(|others| others.without));
    let curves = [
        ("without", &without, CurveStyle::RUNGE_KUTTA),
        ("damper locked", &locked, CurveStyle::SECOND_FORMULA),
        ("with its damper", &with, CurveStyle::FORMULA),
    ];
    let curves = curves.into_iter().filter(|(_, points, _)| points.len() > 1);
    let x_label = match (parameter, parameter.unit()) {
        (PrimaryParameter::Frequency, unit) => format!("frequency of the force ({unit})"),
        (_, "") => parameter.name().to_owned(),
        (_, unit) => format!("{} ({unit})", parameter.name()),
    };
    let is_logarithmic = axis.spacing() == Spacing::Logarithmic && axis.ends()[0] > 0.0;
    let (title, y_label) = match driven {
        true => ("Main mass in the long run", "amplitude (m)"),
        false => ("Rest of the main mass", "rest time (s)"),
    };
    let curves = curves.map(|(label, points, style)| curve(label, points, style)).collect();
    let panel = Panel {
        x_scale: match is_logarithmic {
            true => Scale::Logarithmic,
            false => Scale::Linear,
        },
        ..panel(title, [&x_label, y_label], curves, vec![])
    };
    let caption = match driven {
        true => {
            "Locked and without: in closed form; with its damper: the largest displacement in the last quarter of each run."
        }
        false => {
            "When the envelope of the main mass is down to a tenth. Locked and without: in closed form."
        }
    };
    figure(&[panel], caption)
}

//! The main mass with its damper as comma-separated values and as a picture; text by [`text::document`](super::text::document).

use std::fmt::Write as _;

#[cfg(feature = "plot")]
use super::figure::{Curve, CurveStyle, FigureError, Guide, Panel, figure};
#[cfg(feature = "plot")]
use crate::decimal::decimal;
#[cfg(feature = "plot")]
use crate::impact::Units;
use crate::impact::primary::PrimaryRow;
use crate::report::PrimaryReport;

/// The points of a curve.
const POINTS: u32 = 2000;

/// How many swings of the locked main mass are drawn large.
#[cfg(feature = "plot")]
const FIRST_SWINGS: f64 = 6.0;

/// The times of a table: those asked for, or equal steps and every touch and release.
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

/// Time, angle and its velocity, displacement of the main mass and its velocity, and the energy of both.
///
/// ```
/// use lindstedt::impact::primary::simulate_primary;
/// use lindstedt::problem::Problem;
/// use lindstedt::report::PrimaryReport;
///
/// let file: Problem = "[primary]\nmass = 0.56\nstiffness = 80\ndisplacement = 0.02\n[run]\nduration = 20".parse()?;
/// let asked = file.primary_case(false)?;
/// let motion = simulate_primary(asked.case, &asked.settings)?;
/// let table = lindstedt::export::primary::csv(&PrimaryReport { motion: &motion, units: &asked.units, samples: &[1.0] });
/// assert_eq!(table.lines().count(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn csv(report: &PrimaryReport) -> String {
    let motion = report.motion;
    let mut text = String::from(
        "# units: t 1/omega, x rad, velocity omega, y L, speed L*omega, energy m*g*L\nt,x,velocity,y,speed,energy\n",
    );
    for t in times(report) {
        if let Some(state) = motion.at(t) {
            let energy = motion.case.energy(state);
            let _ = writeln!(
                text,
                "{t},{},{},{},{},{energy}",
                state.x, state.velocity, state.y, state.speed
            );
        }
    }
    match report.doubt() {
        _ if !motion.is_complete() => {
            let _ = writeln!(text, "# incomplete: {}", motion.stop);
        }
        Some(doubt) => {
            let _ = writeln!(text, "# incomplete: {doubt}");
        }
        None => {}
    }
    text
}

/// A row for every frequency.
///
/// ```
/// assert_eq!(lindstedt::export::primary::sweep_csv(&[]).lines().count(), 2);
/// ```
pub fn sweep_csv(rows: &[PrimaryRow]) -> String {
    let mut text = String::from("# units: frequency omega, amplitudes L\nfrequency,amplitude,locked,without,impacts\n");
    let or_none = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    for row in rows {
        let (locked, without) = (
            or_none(row.others.locked.amplitude),
            or_none(row.others.without.amplitude),
        );
        let _ = writeln!(
            text,
            "{},{},{locked},{without},{}",
            row.frequency, row.amplitude, row.impacts
        );
    }
    text
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
/// let asked = file.primary_case(false)?;
/// let motion = simulate_primary(asked.case, &asked.settings)?;
/// let report = PrimaryReport { motion: &motion, units: &asked.units, samples: &[] };
/// assert!(lindstedt::export::primary::picture(&report)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[cfg(feature = "plot")]
pub fn picture(report: &PrimaryReport) -> Result<String, FigureError> {
    let motion = report.motion;
    let (second, metre) = (report.units.time(), report.units.length);
    let all = PrimaryReport {
        samples: &[],
        ..*report
    };
    let states: Vec<_> = times(&all)
        .into_iter()
        .filter_map(|t| Some((t, motion.at(t)?)))
        .collect();
    let with: Vec<(f64, f64)> = states.iter().map(|(t, state)| (t * second, state.y * metre)).collect();
    let angle: Vec<(f64, f64)> = states.iter().map(|(t, state)| (t * second, state.x)).collect();
    let energy: Vec<(f64, f64)> = states
        .iter()
        .map(|(t, state)| (t * second, motion.case.energy(*state)))
        .collect();
    let [locked, without] = [motion.case.primary.mass + 1.0, motion.case.primary.mass];
    // The first swings whole, and how all of them decay.
    let first: Vec<f64> = states
        .iter()
        .map(|(t, _)| *t)
        .take_while(|t| *t <= FIRST_SWINGS * std::f64::consts::TAU * (locked / motion.case.primary.stiffness).sqrt())
        .collect();
    let early: Vec<(f64, f64)> = with.iter().take(first.len()).copied().collect();
    let [locked_swings, swings_without] = [locked, without].map(|mass| swings_alone(report, mass, &first));
    let some_times: Vec<f64> = states.iter().step_by(10).map(|(t, _)| *t).collect();
    let [locked_decay, decay_without] = [locked, without].map(|mass| decay_alone(report, mass, &some_times));
    let curve = |label, points, style| Curve { label, points, style };
    let own = |points| curve("with its damper", points, CurveStyle::DIFFERENCE);
    let (mut all, mut some) = (vec![own(with.as_slice())], vec![own(early.as_slice())]);
    // Driven, the closed forms are those of the long run alone.
    if motion.case.primary.force == 0.0 {
        some.insert(0, curve("without", swings_without.as_slice(), CurveStyle::RUNGE_KUTTA));
        some.insert(
            1,
            curve("damper locked", locked_swings.as_slice(), CurveStyle::SECOND_FORMULA),
        );
        if let (Some(locked), Some(without)) = (&locked_decay, &decay_without) {
            all.push(curve("without", without.as_slice(), CurveStyle::RUNGE_KUTTA));
            all.push(curve("damper locked", locked.as_slice(), CurveStyle::SECOND_FORMULA));
        }
    }
    let barriers = [motion.case.model.left, motion.case.model.right].into_iter().flatten();
    let barriers = barriers.map(|place| Guide::Y(place, "barrier")).collect();
    const TIME: &str = "time t (s)";
    const PLACE: &str = "displacement y (m)";
    let panel = |title, y_label, curves| Panel {
        title,
        x_label: TIME,
        y_label,
        curves,
        ..Panel::default()
    };
    let panels = [
        panel("Main mass, first swings", PLACE, some),
        panel("Main mass", PLACE, all),
        Panel {
            guides: barriers,
            ..panel(
                "Pendulum",
                "angle x (rad)",
                vec![curve("pendulum", angle.as_slice(), CurveStyle::THIRD_FORMULA)],
            )
        },
        panel(
            "Energy of both",
            "energy (m g L)",
            vec![curve("energy", energy.as_slice(), CurveStyle::THIRD_FORMULA)],
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
#[cfg(feature = "plot")]
fn swings_alone(report: &PrimaryReport, mass: f64, times: &[f64]) -> Vec<(f64, f64)> {
    let (case, units) = (&report.motion.case, report.units);
    let [.., y, speed] = case.start;
    let height = |t: f64| case.primary.alone_at(mass, [y, speed], t) * units.length;
    times.iter().map(|t| (t * units.time(), height(*t))).collect()
}

/// The amplitude of these swings; nothing where the mass creeps back.
#[cfg(feature = "plot")]
fn decay_alone(report: &PrimaryReport, mass: f64, times: &[f64]) -> Option<Vec<(f64, f64)>> {
    let (case, units) = (&report.motion.case, report.units);
    let [.., y, speed] = case.start;
    let points = times.iter().map(|t| {
        let height = case.primary.alone_envelope(mass, [y, speed], *t)?;
        Some((t * units.time(), height * units.length))
    });
    points.collect()
}

/// The amplitude of the main mass over the frequency of its force.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::impact::primary::sweep_primary;
/// use lindstedt::problem::Problem;
///
/// let file: Problem = "[primary]\nmass = 0.56\nstiffness = 80\nforce = 0.01\ndamping = 0.5\n[run]\nduration = 20".parse()?;
/// let asked = file.primary_case(true)?;
/// let rows = sweep_primary(asked.case, &[0.8, 1.0], &asked.settings, |_| ())?;
/// assert!(lindstedt::export::primary::sweep_picture(&rows, &asked.units)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[cfg(feature = "plot")]
pub fn sweep_picture(rows: &[PrimaryRow], units: &Units) -> Result<String, FigureError> {
    let points = |value: &dyn Fn(&PrimaryRow) -> Option<f64>| -> Vec<(f64, f64)> {
        let point = |row: &PrimaryRow| Some((row.frequency / units.time(), value(row)? * units.length));
        rows.iter().filter_map(point).collect()
    };
    let with = points(&|row| Some(row.amplitude));
    let locked = points(&|row| row.others.locked.amplitude);
    let without = points(&|row| row.others.without.amplitude);
    let curve = |label, points, style| Curve { label, points, style };
    let panel = Panel {
        title: "Main mass in the long run",
        x_label: "frequency of the force (rad/s)",
        y_label: "amplitude (m)",
        curves: vec![
            curve("without", without.as_slice(), CurveStyle::RUNGE_KUTTA),
            curve("damper locked", locked.as_slice(), CurveStyle::SECOND_FORMULA),
            curve("with its damper", with.as_slice(), CurveStyle::FORMULA),
        ],
        ..Panel::default()
    };
    figure(
        &[panel],
        "Locked and without: in closed form; with its damper: the largest displacement in the last quarter of each run.",
    )
}

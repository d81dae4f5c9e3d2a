//! Impact orbits as a picture and as a table of comma-separated values.

use std::fmt::Write as _;

use super::figure::{Curve, CurveStyle, FigureError, Panel, figure};
use crate::orbits::{
    BranchPoint, FoundOrbits, ImpactEquation, OrbitChange, OrbitChart, OrbitStability, OrbitSweep,
};
use crate::report::family_in_words;

type Points = Vec<(f64, f64)>;

/// The impact speeds along a parameter: stable orbits as lines, unstable ones dashed, those that no
/// motion follows thin and grey, and where orbits change.
///
/// # Errors
/// [`FigureError`], as of [`figure`]; nothing to draw where there is no orbit.
pub fn sweep_picture(question: &ImpactEquation, sweep: &OrbitSweep) -> Result<String, FigureError> {
    let mut lines: Vec<(String, Points, CurveStyle)> = Vec::new();
    for branch in &sweep.branches {
        let is_alike = |a: &BranchPoint, b: &BranchPoint| look(a).0 == look(b).0;
        let mut before: Option<BranchPoint> = None;
        for part in branch.points.chunk_by(is_alike) {
            let (words, style) = look(&part[0]);
            // A part begins where the one before ends, so that no gap is drawn.
            let points: Points =
                before.iter().chain(part).map(|own| (own.parameter, own.speed)).collect();
            before = part.last().copied();
            if points.len() > 1 {
                lines.push((words.to_owned(), points, style));
            }
        }
    }
    // What no motion follows lies below what it follows.
    lines.sort_by_key(|(words, ..)| words != NOT_PHYSICAL);
    for (change, words, style) in MARKS {
        let points: Points = sweep
            .changes
            .iter()
            .filter(|own| own.change == change)
            .map(|own| (own.parameter, own.speed.unwrap_or(0.0)))
            .collect();
        if !points.is_empty() {
            lines.push((words.to_owned(), points, style));
        }
    }
    let curves = lines.iter().map(|(label, points, style)| Curve { label, points, style: *style });
    let x_label = sweep.vary.name.to_string();
    let panel = Panel {
        title: "Impact orbits",
        x_label: &x_label,
        y_label: "speed before the impact",
        curves: curves.collect(),
        ..Panel::default()
    };
    figure(&[panel], &caption(question, &sweep.at))
}

const NOT_PHYSICAL: &str = "not physical";

/// The words and the style of an orbit.
fn look(point: &BranchPoint) -> (&'static str, CurveStyle) {
    match (point.admissible, point.stability) {
        (false, _) => (NOT_PHYSICAL, CurveStyle::ONE_OF_MANY),
        (true, OrbitStability::Stable) => ("stable", CurveStyle::DIFFERENCE),
        (true, OrbitStability::Marginal) => ("marginal", CurveStyle::THIRD_FORMULA),
        (true, OrbitStability::Unstable) => ("unstable", CurveStyle::UNSTABLE),
    }
}

const MARKS: [(OrbitChange, &str, CurveStyle); 5] = [
    (OrbitChange::Grazing, "grazing", CurveStyle::SECOND_MARKED_POINTS),
    (OrbitChange::Fold, "fold", CurveStyle::THIRD_MARKED_POINTS),
    (OrbitChange::PeriodDoubling, "period doubling", CurveStyle::MARKED_POINTS),
    (OrbitChange::SymmetryBreaking, "symmetry breaking", CurveStyle::FOURTH_MARKED_POINTS),
    (OrbitChange::SecondImpact, "second impact", CurveStyle::FOURTH_MARKED_POINTS),
];

/// The equation, its walls and values below a picture.
fn caption(question: &ImpactEquation, at: &crate::values::Values) -> String {
    let walls = question
        .walls
        .iter()
        .map(|own| format!("; {} > 0, restitution {}", own.wall.gap, own.wall.restitution));
    let values = at.iter().map(|(name, value)| format!("; {name} = {value}"));
    let equation = question.oscillator.equation();
    format!("{} = 0{}.", equation.left, walls.chain(values).collect::<String>())
}

/// The chart over two parameters: dots where orbits are stable, by the least number of periods, where
/// only unstable ones exist, and the curves at which orbits change.
///
/// # Errors
/// [`FigureError`], as of [`figure`]; nothing to draw where there is no orbit and no curve.
pub fn chart_picture(question: &ImpactEquation, chart: &OrbitChart) -> Result<String, FigureError> {
    let mut layers: Vec<(String, Points, CurveStyle)> = Vec::new();
    let dots = [CurveStyle::ONE_MOTION, CurveStyle::TWO_MOTIONS, CurveStyle::MANY_MOTIONS];
    let mut add = |label: String, place: (f64, f64), style: CurveStyle| match layers
        .iter_mut()
        .find(|(known, ..)| *known == label)
    {
        Some((_, points, _)) => points.push(place),
        None => layers.push((label, vec![place], style)),
    };
    let [columns, rows] = chart.size;
    // More dots than this run into each other, and make the file large; a panel is wider than high.
    let every = [columns.div_ceil(100), rows.div_ceil(40)];
    for (index, point) in chart.points.iter().enumerate() {
        if (index % columns) % every[0] != 0 || (index / columns) % every[1] != 0 {
            continue;
        }
        let [x, y] = chart.place(index);
        let stable = point.stable.iter().position(|count| *count > 0);
        match stable {
            Some(family) => {
                let periods = chart.families[family].periods as usize;
                let label = match chart.families[family].periods {
                    1 | 2 => format!("{} stable", family_in_words(chart.families[family])),
                    _ => "longer orbit stable".to_owned(),
                };
                add(label, (x, y), dots[(periods - 1).min(2)]);
            }
            None if point.orbits.iter().any(|count| *count > 0) => {
                add("unstable orbits alone".to_owned(), (x, y), CurveStyle::NO_MOTION);
            }
            None => {}
        }
    }
    layers.sort_by(|a, b| a.0.cmp(&b.0));
    for curve in &chart.curves {
        let style = match curve.change {
            OrbitChange::Grazing => CurveStyle::EQUILIBRIUM,
            OrbitChange::Fold => CurveStyle::THIRD_FORMULA,
            OrbitChange::PeriodDoubling => CurveStyle::FORMULA,
            OrbitChange::SymmetryBreaking | OrbitChange::SecondImpact => {
                CurveStyle::SECOND_DIFFERENCE
            }
        };
        let words = curve.change.name().replace('-', " ");
        for piece in &curve.pieces {
            layers.push((words.clone(), piece.iter().map(|[x, y]| (*x, *y)).collect(), style));
        }
    }
    let curves = layers.iter().map(|(label, points, style)| Curve { label, points, style: *style });
    let [x_label, y_label] = [chart.across, chart.upwards].map(|own| own.name.to_string());
    let panel = Panel {
        title: "Orbits with one impact",
        x_label: &x_label,
        y_label: &y_label,
        curves: curves.collect(),
        ..Panel::default()
    };
    figure(&[panel], &caption(question, &chart.at))
}

/// The orbits at values, an impact a row.
pub fn csv(found: &FoundOrbits) -> String {
    let mut text = String::from(
        "orbit,kind,periods,wall,time,phase,speed_before,multiplier_1_re,multiplier_1_im,multiplier_2_re,multiplier_2_im,stability,admissible,return_error\n",
    );
    for (number, own) in found.orbits.iter().enumerate() {
        let orbit = &own.orbit;
        let [a, b] = orbit.multipliers;
        let error = own.verdict.as_ref().map(|own| own.return_error).filter(|own| own.is_finite());
        let error = error.map_or(String::new(), |error| error.to_string());
        for impact in &orbit.impacts {
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{},{},{},{},{},{},{error}",
                number + 1,
                orbit.kind.name(),
                orbit.periods,
                impact.wall + 1,
                impact.time,
                impact.phase,
                impact.speed,
                a.re,
                a.im,
                b.re,
                b.im,
                orbit.stability.name(),
                orbit.is_admissible(),
            );
        }
    }
    text
}

/// The branches along a parameter, an orbit a row, and the places where orbits change.
pub fn sweep_csv(sweep: &OrbitSweep) -> String {
    let name = sweep.vary.name;
    let mut text =
        format!("kind,periods,wall,branch,{name},speed_before,phase,stability,admissible\n");
    for (number, branch) in sweep.branches.iter().enumerate() {
        let family = branch.family;
        for own in &branch.points {
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{},{}",
                family.kind.name(),
                family.periods,
                family.wall + 1,
                number + 1,
                own.parameter,
                own.speed,
                own.phase,
                own.stability.name(),
                own.admissible
            );
        }
    }
    for own in &sweep.changes {
        let speed = own.speed.map_or(String::new(), |speed| speed.to_string());
        let family = own.family;
        let _ = writeln!(
            text,
            "{},{},{},,{},{speed},,,",
            own.change.name(),
            family.periods,
            family.wall + 1,
            own.parameter
        );
    }
    text
}

/// The points of a chart: of each family the number of orbits, and of stable ones.
pub fn chart_csv(chart: &OrbitChart) -> String {
    let mut text = format!("{},{}", chart.across.name, chart.upwards.name);
    for family in &chart.families {
        let name = format!("{}_{}_wall_{}", family.kind.name(), family.periods, family.wall + 1);
        let _ = write!(text, ",{name},{name}_stable");
    }
    text.push('\n');
    for (index, point) in chart.points.iter().enumerate() {
        let [x, y] = chart.place(index);
        let _ = write!(text, "{x},{y}");
        for (orbits, stable) in point.orbits.iter().zip(&point.stable) {
            let _ = write!(text, ",{orbits},{stable}");
        }
        text.push('\n');
    }
    text
}

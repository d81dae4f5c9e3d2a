//! The blocks of an impact as text.

use super::comparison::wrapped;
use super::percent;
use crate::decimal::{decimal, significant};
use crate::impact::contact::{ContactLaw, ContactRow};
use crate::impact::{
    FittedLine, ImpactQuantity, ImpactRow, ImpactSymbols, MotionPhase, PhaseReading, Rule,
};
use crate::verify::Verdict;

/// The line in place of the force of the barrier.
pub(super) fn fitted(
    fitted: &FittedLine,
    barrier: f64,
    rule: Rule,
    letters: ImpactSymbols,
    per_stiffness: bool,
) -> String {
    let constant = fitted.line.q(barrier);
    let line = format!(
        "{}*{} {} {}",
        decimal(fitted.line.slope),
        letters.coordinate,
        if constant < 0.0 { '+' } else { '-' },
        decimal(constant.abs())
    );
    let force = match per_stiffness {
        true => format!("{}*({line})", letters.stiffness),
        false => line,
    };
    format!("  elastic force {force}, fitted by {rule} over the depth {}\n", decimal(fitted.depth))
}

pub(super) fn phase(phase: &MotionPhase, letters: ImpactSymbols, release: &str) -> String {
    let (x, barrier) = (letters.coordinate, letters.barrier);
    let way = match phase.name {
        "approach" => format!("{x} = {release} to {x} = {barrier}"),
        "contact" => format!("{x} = {barrier} to {x} = {barrier}"),
        _ => format!("{x} = {barrier} to {x} = {release}"),
    };
    let (start, end) = (decimal(phase.start), decimal(phase.end));
    format!(
        "  {:<9} {way},  {start} <= t <= {end}\n            {}\n",
        phase.name,
        phase.closed_form_of(x)
    )
}

/// A table: Runge-Kutta and every column, and below each number its error.
pub(super) fn quantities(
    columns: &[PhaseReading],
    rows: &[ImpactQuantity],
    deviations: &[f64],
    shapes: &[[f64; 3]],
) -> String {
    let line = |name: &str, cells: Vec<String>| {
        let cells: String = cells.iter().map(|cell| format!("{cell:>13}")).collect();
        format!("  {name:<19}{cells}").trim_end().to_owned()
    };
    let first = |rest: &mut dyn Iterator<Item = String>, cell: String| -> Vec<String> {
        std::iter::once(cell).chain(rest).collect()
    };
    let names = &mut columns.iter().map(|reading| reading.name().to_owned());
    let mut lines = vec![line("", first(names, "Runge-Kutta".to_owned()))];
    for row in rows {
        let values = &mut row.closed_forms.iter().map(|value| decimal(*value));
        lines.push(line(row.name, first(values, decimal(row.runge_kutta))));
        lines.push(line("", first(&mut row.errors().map(percent), String::new())));
    }
    let size = |size: f64| format!("{} %", significant(100.0 * size, 3));
    let deviations = &mut deviations.iter().map(|deviation| size(*deviation));
    lines.push(line("largest deviation", first(deviations, String::new())));
    for (index, name) in
        ["of the approach", "of the contact", "of the return"].into_iter().enumerate()
    {
        let shapes = &mut shapes.iter().map(|shape| size(shape[index]));
        lines.push(line(&format!("  {name}"), first(shapes, String::new())));
    }
    lines.join("\n") + "\n"
}

/// A table of laws: the numbers of each, and below them their errors.
pub(super) fn contact_laws(rows: &[ContactRow]) -> String {
    let line = |name: &str, cells: [String; 4]| {
        let cells: String = cells.iter().map(|cell| format!("{cell:>14}")).collect();
        format!("  {name:<21}{cells}").trim_end().to_owned() + "\n"
    };
    let head = ["duration", "penetration", "peak force", "motion"];
    let mut text = line("", head.map(str::to_owned));
    for row in rows {
        let Ok((motion, errors)) = &row.outcome else {
            continue;
        };
        let numbers = [motion.duration, motion.depth, motion.peak_force].map(decimal);
        let [duration, depth, force] = numbers;
        text += &line(row.law.name(), [duration, depth, force, String::new()]);
        if row.law != ContactLaw::Exact {
            let errors_of = [errors.duration, errors.depth, errors.peak_force].map(percent);
            let [duration, depth, force] = errors_of;
            let motion = format!("{} %", significant(100.0 * errors.motion, 3));
            text += &line("", [duration, depth, force, motion]);
        }
    }
    text + "  below each law its errors against the exact one; motion: the largest difference of\n"
        + "  depth at the same time, of the greatest depth; forces are per unit of mass\n"
}

/// A table of methods: the errors of each in percent, the numbers of the true motion above them.
pub(super) fn methods(rows: &[ImpactRow], truth: [f64; 5], tolerance: f64, width: usize) -> String {
    const HEAD: [&str; 8] =
        ["to contact", "speed", "depth", "duration", "period", "approach", "contact", "return"];
    let titles: Vec<String> = rows.iter().map(ImpactRow::title).collect();
    let longest = titles.iter().map(|title| title.chars().count()).max().unwrap_or(0);
    // Names get lines of their own if the numbers leave no room beside them.
    let beside = longest + 88 <= width;
    let line = |name: &str, cells: [String; 8], last: &str| {
        let widths = [11, 11, 11, 11, 11, 9, 9, 9];
        let cells: String =
            cells.iter().zip(widths).map(|(cell, width)| format!("{cell:>width$}")).collect();
        let cells = format!("{cells}  {last}");
        match (beside, name) {
            (true, _) => format!("{name:<longest$}{}\n", cells.trim_end()),
            (false, "") => format!("{}\n", cells.trim_end()),
            (false, _) => format!("{name}\n{}\n", cells.trim_end()),
        }
    };
    let mut text = line("", HEAD.map(str::to_owned), "");
    let known = truth.map(decimal);
    let cells = std::array::from_fn(|index| known.get(index).cloned().unwrap_or_default());
    text += &line("Runge-Kutta", cells, "");
    let percent = |error: f64, digits: usize| match error.abs() < 1e-9 {
        true => "< 1e-7".to_owned(),
        false => significant(100.0 * error, digits),
    };
    for (row, title) in rows.iter().zip(&titles) {
        let cells = std::array::from_fn(|index| match index {
            0..5 => percent(row.errors[index], 3),
            _ => percent(row.deviations[index - 5], 2),
        });
        text += &line(title, cells, row.verdict(tolerance).name());
    }
    let tolerance = significant(100.0 * tolerance, 3);
    text + "\n"
        + &wrapped(
            &format!(
                "Of each method the errors of the five numbers and the largest deviation in each phase, on its own clock, of the amplitude or \
             of the depth, all in percent; pass: all within {tolerance} %."
            ),
            width,
            "",
            "",
        )
        + "\n"
}

/// A quantity in SI units, with its formula.
pub(super) fn si_value(
    name: &str,
    formula: Option<&str>,
    value: f64,
    unit: &str,
    words: &str,
) -> String {
    let formula = formula.map_or(String::new(), |formula| format!("{formula} = "));
    let number = format!("{} {unit}", decimal(value));
    format!("  {name:<5} = {formula}{}   ({words})\n", number.trim_end())
}

/// A table in SI units: Runge-Kutta and every column.
pub(super) fn si_quantities(columns: &[PhaseReading], rows: &[(ImpactQuantity, &str)]) -> String {
    let line = |name: &str, cells: &mut dyn Iterator<Item = String>| {
        let cells: String = cells.map(|cell| format!("{cell:>13}")).collect();
        format!("  {name:<24}{cells}\n")
    };
    let names = std::iter::once("Runge-Kutta").chain(columns.iter().map(|reading| reading.name()));
    let mut text = line("", &mut names.map(str::to_owned));
    for (row, unit) in rows {
        let name = match *unit {
            "" => row.name.to_owned(),
            unit => format!("{}, {unit}", row.name),
        };
        let values = std::iter::once(&row.runge_kutta).chain(&row.closed_forms);
        text += &line(&name, &mut values.map(|value| decimal(*value)));
    }
    text
}

pub(super) fn verdicts(verdicts: &[(PhaseReading, Verdict)], tolerance: f64) -> String {
    let each: Vec<String> = verdicts
        .iter()
        .map(|(reading, verdict)| format!("{} {}", reading.name(), verdict.name()))
        .collect();
    format!(
        "  verdict (every number and phase within {} %): {}\n",
        significant(100.0 * tolerance, 3),
        each.join(", ")
    )
}

//! The blocks of an impact as text.

use super::percent;
use crate::decimal::{decimal, significant};
use crate::impact::{FittedLine, Letters, Phase, Quantity, Reading, Rule};
use crate::verify::Verdict;

/// The line in place of the force of the barrier.
pub(super) fn fitted(fitted: &FittedLine, barrier: f64, rule: Rule, letters: Letters, per_stiffness: bool) -> String {
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
    format!(
        "  elastic force {force}, fitted by {rule} over the depth {}\n",
        decimal(fitted.depth)
    )
}

pub(super) fn phase(phase: &Phase, letters: Letters, release: &str) -> String {
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
pub(super) fn quantities(columns: &[Reading], rows: &[Quantity], deviations: &[f64], shapes: &[[f64; 3]]) -> String {
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
    for (index, name) in ["of the approach", "of the contact", "of the return"]
        .into_iter()
        .enumerate()
    {
        let shapes = &mut shapes.iter().map(|shape| size(shape[index]));
        lines.push(line(&format!("  {name}"), first(shapes, String::new())));
    }
    lines.join("\n") + "\n"
}

pub(super) fn verdicts(verdicts: &[(Reading, Verdict)], tolerance: f64) -> String {
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

pub(super) fn shortcoming(reading: Reading, errors: &[(&'static str, f64)], cause: &str) -> String {
    let errors: Vec<String> = errors
        .iter()
        .map(|(name, error)| format!("{name} {}", percent(*error)))
        .collect();
    format!("    {:<8}{}: {cause}\n", reading.name(), errors.join(", "))
}

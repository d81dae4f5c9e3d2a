//! The blocks of an impact as text.

use super::percent;
use crate::decimal::{decimal, significant};
use crate::impact::{ContactSpeed, Phase, Quantity};
use crate::verify::Verdict;

/// What the phases that follow begin their contact with.
pub(super) fn speed(speed: ContactSpeed) -> String {
    let words = match speed {
        ContactSpeed::Paper => "The paper's way: every join continuous, contact speed from the one-term motion",
        ContactSpeed::Energy => "With the contact speed from the energy, v = sqrt(2*(cos(xc) - cos(A)))",
    };
    format!("{words}\n")
}

pub(super) fn phase(phase: &Phase) -> String {
    let way = match phase.name {
        "approach" => "x = -A to x = xc",
        "contact" => "x = xc to x = xc",
        _ => "x = xc to x = -A",
    };
    let (start, end) = (decimal(phase.start), decimal(phase.end));
    format!(
        "  {:<9} {way},  {start} <= t <= {end}\n            {}\n",
        phase.name,
        phase.closed_form()
    )
}

/// A table: Runge-Kutta, and by either speed the number and its error.
pub(super) fn quantities(rows: &[Quantity], deviations: &[f64; 2]) -> String {
    let line = |name: &str, cells: [String; 5]| {
        let cells: String = cells.iter().map(|cell| format!("{cell:>12}")).collect();
        format!("  {name:<18}{cells}")
    };
    let head = ["Runge-Kutta", "paper", "", "", "energy"].map(str::to_owned);
    let mut lines = vec![line("", head)];
    lines.extend(rows.iter().map(|row| {
        let cells = [
            decimal(row.runge_kutta),
            decimal(row.paper),
            percent(row.paper_error()),
            decimal(row.energy),
            percent(row.energy_error()),
        ];
        line(row.name, cells)
    }));
    let [paper, energy] = deviations.map(|size| format!("{} %", significant(100.0 * size, 3)));
    let deviations = [String::new(), paper, String::new(), energy, String::new()];
    lines.push(line("largest deviation", deviations).trim_end().to_owned());
    lines.join("\n") + "\n"
}

pub(super) fn verdicts([paper, energy]: &[Verdict; 2], tolerance: f64) -> String {
    format!(
        "  verdict (every number within {} %): paper {}, energy {}\n",
        significant(100.0 * tolerance, 3),
        paper.name(),
        energy.name()
    )
}

pub(super) fn shortcoming(speed: ContactSpeed, errors: &[(&'static str, f64)], cause: &str) -> String {
    let errors: Vec<String> = errors
        .iter()
        .map(|(name, error)| format!("{name} {}", percent(*error)))
        .collect();
    let speed = match speed {
        ContactSpeed::Paper => "paper",
        ContactSpeed::Energy => "energy",
    };
    format!("    {speed:<8}{}: {cause}\n", errors.join(", "))
}

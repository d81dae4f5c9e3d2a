//! The blocks of an impact as LaTeX.

use super::table::{self, LatexTable};
use super::{scientific, scientific_text};
use crate::decimal::significant;
use crate::export::latex::{symbol, typed};
use crate::impact::contact::ContactRow;
use crate::impact::{
    FittedLine, Form, ImpactQuantity, ImpactRow, ImpactSymbols, MotionPhase, PhaseReading, Rule,
    TimeFunction,
};

/// The head of the phases of a version.
pub(super) fn reading(reading: PhaseReading) -> String {
    let words = match reading {
        PhaseReading::Paper => "contact speed from the one-term motion",
        PhaseReading::Energy => "contact speed from the energy",
        PhaseReading::Derived => "derived motion with all harmonics",
    };
    format!("&\\text{{{words}:}}")
}

/// The line in place of the force of the barrier, and the rule of its fit.
pub(super) fn fitted(
    fitted: &FittedLine,
    barrier: f64,
    rule: Rule,
    letters: ImpactSymbols,
    per_stiffness: bool,
) -> String {
    let line = format!(
        "{}\\,{} {}",
        scientific(fitted.line.slope),
        symbol(letters.coordinate),
        signed(-fitted.line.q(barrier))
    );
    let force = match per_stiffness {
        true => format!("{}\\left({line}\\right)", symbol(letters.stiffness)),
        false => line,
    };
    format!(
        "&\\text{{elastic force }} {force} \\text{{,}} \\qquad \\text{{{rule} over the depth }} {}",
        scientific(fitted.depth)
    )
}

/// A table: Runge-Kutta, and by every column the number and its error.
pub(super) fn quantities(columns: &[PhaseReading], rows: &[ImpactQuantity]) -> LatexTable {
    let percent = |error: f64| format!("${}\\,\\%$", scientific((1e5 * error).round() / 1e3));
    let row = |row: &ImpactQuantity| {
        let cells = row.closed_forms.iter().zip(row.errors());
        let first = [row.name.to_owned(), number(row.runge_kutta)];
        let rest = cells.flat_map(|(value, error)| [number(*value), percent(error)]);
        first.into_iter().chain(rest).collect()
    };
    let names = columns.iter().flat_map(|column| [column.name(), "error"]);
    let head: Vec<&str> = ["", "Runge--Kutta"].into_iter().chain(names).collect();
    LatexTable::of_numbers(table::head(&head), rows.iter().map(row).collect())
}

fn number(value: f64) -> String {
    format!("${}$", scientific(value))
}

/// A quantity in SI units, with its formula.
pub(super) fn si_value(name: &str, formula: Option<&str>, value: f64, unit: &str) -> String {
    let formula = formula.map_or(String::new(), |formula| format!("{} = ", typed(formula)));
    let unit = match unit {
        "" => String::new(),
        unit => format!("\\,{}", upright(unit)),
    };
    format!("{} &= {formula}{}{unit}", typed(name), scientific(value))
}

/// A unit as it is typed, set upright.
fn upright(unit: &str) -> String {
    match unit.bytes().all(|letter| letter.is_ascii_alphabetic()) {
        true => format!("\\mathrm{{{unit}}}"),
        false => format!("\\mathrm{{{}}}", typed(unit)),
    }
}

/// A table in SI units: Runge-Kutta and every column.
pub(super) fn si_quantities(
    columns: &[PhaseReading],
    rows: &[(ImpactQuantity, &str)],
) -> LatexTable {
    let row = |(row, unit): &(ImpactQuantity, &str)| {
        let name = match *unit {
            "" => row.name.to_owned(),
            unit => format!("{}, ${}$", row.name, upright(unit)),
        };
        let values = std::iter::once(&row.runge_kutta).chain(&row.closed_forms);
        std::iter::once(name).chain(values.map(|value| number(*value))).collect()
    };
    let names = columns.iter().map(|column| column.name());
    let head: Vec<&str> = ["", "Runge--Kutta"].into_iter().chain(names).collect();
    LatexTable::of_numbers(table::head(&head), rows.iter().map(row).collect())
}

/// A table of laws: the numbers of each and their errors in percent.
pub(super) fn contact_laws(rows: &[ContactRow]) -> LatexTable {
    let percent = |error: f64| number((1e5 * error).round() / 1e3);
    let row = |row: &ContactRow| -> Option<Vec<String>> {
        let (motion, errors) = row.outcome.as_ref().ok()?;
        let pairs = [
            (motion.duration, errors.duration),
            (motion.depth, errors.depth),
            (motion.peak_force, errors.peak_force),
        ];
        let pairs = pairs.map(|(value, error)| [number(value), percent(error)]);
        let last = percent(errors.motion);
        let cells = std::iter::once(row.law.to_string()).chain(pairs.into_iter().flatten());
        Some(cells.chain([last]).collect())
    };
    let head = ["law", "duration", "\\%", "penetration", "\\%", "peak force", "\\%", "motion, \\%"];
    LatexTable::of_numbers(table::head(&head), rows.iter().filter_map(row).collect())
}

/// A table of methods: the errors of each in percent.
pub(super) fn methods(rows: &[ImpactRow], truth: [f64; 5]) -> LatexTable {
    let percent = |value: f64| match value.abs() < 1e-9 {
        true => "$< 10^{-7}$".to_owned(),
        false => format!("${}$", scientific_text(&significant(100.0 * value, 3))),
    };
    let known = truth.map(number).into_iter().chain(vec![String::new(); 3]);
    let known = std::iter::once("Runge--Kutta".to_owned()).chain(known).collect();
    let row = |row: &ImpactRow| {
        let cells = row.errors.iter().chain(&row.deviations);
        let cells = cells.map(|value| percent(*value));
        std::iter::once(row.title()).chain(cells).collect()
    };
    let head = [
        "errors in \\%",
        "$t_1$",
        "speed",
        "penetration",
        "duration",
        "period",
        "approach",
        "contact",
        "return",
    ];
    let rows = std::iter::once(known).chain(rows.iter().map(row)).collect();
    LatexTable::of_numbers(table::head(&head), rows)
}

fn signed(value: f64) -> String {
    format!("{} {}", if value < 0.0 { '-' } else { '+' }, scientific(value.abs()))
}

/// The name of a phase, its interval of time, and its closed form, a few waves to a row.
pub(super) fn phase(phase: &MotionPhase, letters: ImpactSymbols) -> Vec<String> {
    const WAVES_IN_A_ROW: usize = 3;
    let clock = match phase.joined_at() {
        Some(join) => format!("(t - t_{{{join}}})"),
        None => "t".to_owned(),
    };
    let mut waves: Vec<String> = Vec::new();
    match &phase.form {
        &Form::Cosine { amplitude, frequency, phase } => {
            let shift = if phase == 0.0 { String::new() } else { format!(" {}", signed(phase)) };
            waves.push(format!(
                "{} \\cos\\left({}\\,{clock}{shift}\\right)",
                scientific(amplitude),
                scientific(frequency)
            ));
        }
        &Form::Oscillation { centre, amplitude, frequency } => {
            let angle = format!("\\left({}\\,{clock}\\right)", scientific(frequency));
            let centre = scientific_text(&significant(centre, 9));
            waves.push(format!(
                "{centre} {} \\cos{angle} {} \\sin{angle}",
                signed(amplitude.re),
                signed(-amplitude.im)
            ));
        }
        Form::Harmonics { .. } | Form::Contact { .. } => {
            for (term, value) in phase.form.felt_terms() {
                let size = if waves.is_empty() { scientific(value) } else { signed(value) };
                waves.push(match term {
                    TimeFunction::Constant => scientific_text(&significant(value, 9)),
                    TimeFunction::Parabola => format!("{size}\\,{clock}(t_{{2}} - t)"),
                    TimeFunction::Wave { function, frequency } => {
                        format!(
                            "{size} \\{function}\\left({}\\,{clock}\\right)",
                            scientific(frequency)
                        )
                    }
                });
            }
        }
    }
    let (from, to) = match phase.name {
        "approach" => ("0", format!("t_{{1}} = {}", scientific(phase.end))),
        "contact" => ("t_{1}", format!("t_{{2}} = {}", scientific(phase.end))),
        _ if phase.joined_at() == Some(3) => {
            ("t_{2}", format!("t_{{3}} = {}", scientific(phase.end)))
        }
        _ => ("t_{2}", scientific(phase.end)),
    };
    let mut rows = vec![format!("&\\text{{{},}} \\quad {from} \\le t \\le {to}", phase.name)];
    for (index, waves) in waves.chunks(WAVES_IN_A_ROW).enumerate() {
        let left = match index {
            0 => format!("{}(t) &= ", symbol(letters.coordinate)),
            _ => "&\\quad ".to_owned(),
        };
        rows.push(left + &waves.join(" "));
    }
    rows
}

//! The blocks of an impact as LaTeX.

use super::scientific;
use crate::decimal::significant;
use crate::impact::{ContactSpeed, Form, Phase, Quantity};

/// What the phases that follow begin their contact with.
pub(super) fn speed(speed: ContactSpeed) -> String {
    let words = match speed {
        ContactSpeed::Paper => "contact speed from the one-term motion",
        ContactSpeed::Energy => "contact speed from the energy",
    };
    format!("&\\text{{{words}:}}")
}

/// A table: Runge-Kutta, and by either speed the number and its error.
pub(super) fn quantities(rows: &[Quantity]) -> String {
    let percent = |error: f64| format!("${}\\,\\%$", scientific((1e5 * error).round() / 1e3));
    let row = |row: &Quantity| {
        format!(
            "{} & ${}$ & ${}$ & {} & ${}$ & {} \\\\\n",
            row.name,
            scientific(row.runge_kutta),
            scientific(row.paper),
            percent(row.paper_error()),
            scientific(row.energy),
            percent(row.energy_error())
        )
    };
    let head = " & Runge--Kutta & paper & error & energy & error \\\\\n\\hline\n";
    let rows: String = rows.iter().map(row).collect();
    format!("\\begin{{tabular}}{{lrrrrr}}\n{head}{rows}\\end{{tabular}}\n")
}

/// The name of a phase and when it is, and its closed form.
pub(super) fn phase(phase: &Phase) -> [String; 2] {
    let clock = match phase.joined_at() {
        Some(join) => format!("(t - t_{{{join}}})"),
        None => "t".to_owned(),
    };
    let signed = |value: f64| format!("{} {}", if value < 0.0 { '-' } else { '+' }, scientific(value.abs()));
    let form = match phase.form {
        Form::Cosine {
            amplitude,
            frequency,
            phase,
        } => {
            let shift = if phase == 0.0 {
                String::new()
            } else {
                format!(" {}", signed(phase))
            };
            format!(
                "{} \\cos\\left({}\\,{clock}{shift}\\right)",
                scientific(amplitude),
                scientific(frequency)
            )
        }
        Form::Oscillation {
            centre,
            amplitude,
            frequency,
        } => {
            let angle = format!("\\left({}\\,{clock}\\right)", scientific(frequency));
            let centre = significant(centre, 9);
            format!(
                "{centre} {} \\cos{angle} {} \\sin{angle}",
                signed(amplitude.re),
                signed(-amplitude.im)
            )
        }
    };
    let (from, to) = match phase.name {
        "approach" => ("0", format!("t_{{1}} = {}", scientific(phase.end))),
        "contact" => ("t_{1}", format!("t_{{2}} = {}", scientific(phase.end))),
        _ => ("t_{2}", scientific(phase.end)),
    };
    [
        format!("&\\text{{{},}} \\quad {from} \\le t \\le {to}", phase.name),
        format!("x(t) &= {form}"),
    ]
}

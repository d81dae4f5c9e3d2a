//! The blocks of a comparison as LaTeX.

use super::table::{self, LatexTable};
use super::{constant, expression, scientific, scientific_text, sum, symbol};
use crate::decimal::{decimal, significant};
use crate::expr::{Equation, Expr};
use crate::report::MethodRow;
use crate::solution::law::DisplayedLaw;
use crate::symbol::Symbol;
use crate::symbol::letters::FREQUENCY;
use crate::values::Values;

pub(super) fn truth(equation: &Equation, frequency: &Result<f64, String>) -> String {
    let truth = match frequency {
        Ok(frequency) => decimal(*frequency),
        Err(reason) => format!("not known: {reason}"),
    };
    format!("{equation}; true {FREQUENCY} = {truth}")
}

/// The table, a formula at the end of each row.
pub(super) fn methods(rows: &[MethodRow], at: &Values) -> LatexTable {
    let at = at.iter();
    let at: Vec<String> =
        at.map(|(name, value)| format!("{} = {}", symbol(name), expression(value))).collect();
    let place = match at.is_empty() {
        true => String::new(),
        false => format!(" at ${}$", at.join(", ")),
    };
    let omega = format!("${}${place}", symbol(FREQUENCY));
    LatexTable {
        places: "lrrrl".to_owned(),
        head: table::head(&["method", &omega, "error in \\%", "deviation in \\%", "formula"]),
        rows: rows.iter().map(row).collect(),
        framed: true,
    }
}

fn row(method: &MethodRow) -> Vec<String> {
    let percent = |value: Option<f64>| {
        value.map_or("--".to_owned(), |value| {
            let sign = if value < 0.0 { "-" } else { "" };
            let size = 100.0 * value.abs();
            match size < 1e-7 {
                true => "$< 10^{-7}$".to_owned(),
                false => format!("${sign}{}$", scientific_text(&significant(size, 3))),
            }
        })
    };
    let frequency = method.row.frequency;
    let frequency = frequency.map_or("--".to_owned(), |value| format!("${}$", scientific(value)));
    vec![
        method.title.clone(),
        frequency,
        percent(method.row.relative_error),
        percent(method.row.max_deviation),
        with_hbar(method),
    ]
}

/// The formula of a row, and the hbar with which it was evaluated.
pub(in crate::export) fn with_hbar(method: &MethodRow) -> String {
    let hbar = method.hbar.map(|(name, value)| {
        let value = scientific_text(&significant(value, 6));
        format!(", \\; {} = {value}", symbol(name))
    });
    match formula(method) {
        Ok(formula) => format!("${formula}{}$", hbar.unwrap_or_default()),
        Err(words) => words.to_owned(),
    }
}

/// The law in one line, with the definitions it needs; the error is a text for a law that is not a
/// formula.
fn formula(method: &MethodRow) -> Result<String, &'static str> {
    let ordered = |law| sum(&method.row.solution.ordered(law));
    let slow = method.row.solution.slow();
    let law = match method.law {
        _ if slow.is_some() => {
            let rate = |name: Symbol, right: &Expr| {
                let left = expression(&Expr::from(name.derivative()));
                format!("{left} = {}", expression(right))
            };
            let rates = slow.map(|slow| {
                let amplitude = rate(slow.amplitude, &slow.amplitude_rate);
                format!("{amplitude},\\quad {}", rate(slow.phase, &slow.phase_rate))
            });
            rates.unwrap_or_default()
        }
        DisplayedLaw::Squared(squared) => {
            format!("{}^{{2}} = {}", symbol(FREQUENCY), ordered(squared))
        }
        DisplayedLaw::Closed(_) if method.row.solution.numerical => {
            return Err("closed form, rounded coefficients");
        }
        DisplayedLaw::Closed(form) => {
            let omega = symbol(FREQUENCY);
            let name = if form.squared { omega + "^{2}" } else { omega };
            format!("{name} = {}", expression(&form.value))
        }
        DisplayedLaw::Frequency(frequency) => {
            format!("{} = {}", symbol(FREQUENCY), ordered(frequency))
        }
        DisplayedLaw::Relation(relation) => format!("0 = {}", ordered(relation)),
        DisplayedLaw::Quadrature(_) | DisplayedLaw::System(_) => return Err("by numbers"),
    };
    let definitions = method.definitions.iter().map(|definition| {
        let meaning = constant(&definition.meaning);
        format!(", \\; {} = {meaning}", symbol(definition.symbol))
    });
    Ok(law + &definitions.collect::<String>())
}

//! LaTeX for everything that prints as text: expressions, laws, motions, whole solutions.
//!
//! The output uses `amsmath` and nothing else: `align*`, `\frac`, `\sqrt`, `\left( \right)`, Greek letters and the named
//! functions.

mod expression;

use std::fmt::Write as _;

use num_traits::One;

pub use expression::{expression, symbol};

pub use super::steps::latex as steps;
use crate::decimal::{decimal, rounded_fraction, significant, significant_fraction};
use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, Polynomials, Rational};
use crate::expr::{Equation, Expr, parse_expression};
use crate::impact::{ContactSpeed, Form, Impact, Phase};
use crate::series::FourierSeries;
use crate::series::terms::{self, Notation};
use crate::solution::{LimitCycle, Solution, long_fraction};
use crate::verify::Verification;
use crate::verify::comparison::{Comparison, Row};

/// A polynomial with the lowest power of the small parameter first.
pub(super) fn law(polynomial: &Polynomial, solution: &Solution) -> String {
    terms::polynomial(
        polynomial,
        |monomial| solution.order_of(monomial),
        |monomial, coefficient| coefficient_term(monomial, coefficient, solution.numerical),
    )
}

fn coefficient_term(monomial: &Monomial, coefficient: &Rational, numerical: bool) -> String {
    let term = |number: Rational| expression(&Expr::from(&Polynomial::term(monomial.clone(), number)));
    match numerical && !coefficient.is_integer() {
        false => term(coefficient.clone()),
        true if monomial.factors().is_empty() => scientific_text(&significant_fraction(coefficient, 6)),
        true => format!(
            "{}\\,{}",
            scientific_text(&significant_fraction(coefficient, 6)),
            term(Rational::one())
        ),
    }
}

/// A constant; what must be a rounded number with fifteen of its digits.
fn constant(value: &Expr) -> String {
    match long_fraction(value) {
        Some(number) => expression(&Expr::number(rounded_fraction(number, 15))),
        None => expression(value),
    }
}

fn scientific(value: f64) -> String {
    scientific_text(&decimal(value))
}

fn scientific_text(text: &str) -> String {
    match text.split_once('e') {
        None => text.to_owned(),
        Some((mantissa, exponent)) => format!("{mantissa} \\cdot 10^{{{exponent}}}"),
    }
}

/// An equation of motion or a definition, `left = right`.
pub fn equation(equation: &Equation) -> String {
    format!("{} = {}", expression(&equation.left), expression(&equation.right))
}

/// An equation, `left = right`, or an expression, as it was typed.
pub fn typed(text: &str) -> String {
    let side = |text: &str| parse_expression(text).map_or_else(|_| text.to_owned(), |side| expression(&side));
    match text.split_once('=') {
        Some((left, right)) => format!("{} = {}", side(left), side(right)),
        None => side(text),
    }
}

/// The derived formula, and the verdict where it was judged, to be pasted into an article.
pub fn solution(solution: &Solution, verification: Option<&Verification>) -> String {
    let mut lines = vec![equation(&solution.equation).replacen(" = ", " &= ", 1)];
    if let Some(squared) = solution.law.frequency_squared() {
        lines.push(format!("\\omega^{{2}} &= {}", law(squared, solution)));
    }
    if let Some(frequency) = solution.law.frequency() {
        lines.push(format!("\\omega &= {}", law(frequency, solution)));
    }
    if let (None, Some(relation)) = (solution.law.frequency_squared(), solution.law.relation()) {
        lines.push(format!("0 &= {}", expression(&Expr::from(relation))));
    }
    if let Some(form) = solution.law.closed_form() {
        let name = if form.squared { "\\omega^{2}" } else { "\\omega" };
        lines.push(format!("{name} &= {}", expression(&form.value)));
    }
    let by_numbers = solution.law.quadrature().into_iter().flatten();
    lines.extend(by_numbers.flat_map(super::steps::line_as_latex));
    for equation in solution.law.system().into_iter().flat_map(|system| &system.equations) {
        lines.push(format!("0 &= {}", expression(equation)));
    }
    if let Some(LimitCycle { amplitude, .. }) = &solution.limit_cycle {
        lines.push(format!(
            "{} &= {}",
            symbol(solution.amplitude.symbol()),
            law(amplitude, solution)
        ));
    }
    if !solution.displacement.is_zero() {
        lines.extend(motion(solution));
    }
    for definition in &solution.definitions {
        lines.push(format!(
            "{} &= {}",
            symbol(definition.symbol),
            constant(&definition.meaning)
        ));
    }
    let mut text = String::new();
    let _ = writeln!(text, "% {}; {}", solution.title(), solution.amplitude);
    for line in &solution.validity {
        let _ = writeln!(text, "% {line}");
    }
    for line in solution
        .limit_cycle
        .iter()
        .flat_map(|cycle| super::text::other_cycles(cycle, solution))
    {
        let _ = writeln!(text, "% {line}");
    }
    if let Some(verification) = verification {
        let verdict = verification.verdict.name();
        let error = verification
            .relative_error
            .map_or("none".to_owned(), |error| match error.abs() < 1e-9 {
                true => super::text::percent(error),
                false => decimal(100.0 * error) + " %",
            });
        let truth = decimal(verification.true_frequency);
        let other = verification.error_of_omega.filter(|other| {
            verification
                .relative_error
                .is_none_or(|error| (other - error).abs() > 1e-9)
        });
        let other = other.map_or(String::new(), |other| {
            format!("; of the series of omega itself {} %", decimal(100.0 * other))
        });
        let law = verification.judged_on;
        let _ = writeln!(
            text,
            "% true omega {truth}, relative error {error} (by {law}{other}), verdict {verdict}"
        );
    }
    let _ = writeln!(text, "\\begin{{align*}}\n{}\n\\end{{align*}}", lines.join(" \\\\\n"));
    text
}

/// The story of an impact: equation, law, three phases by either column, and the numbers beside Runge-Kutta.
pub fn impact(impact: &Impact, tolerance: f64) -> String {
    let setup = &impact.setup;
    let mut lines = vec![typed(&impact.equation).replacen(" = ", " &= ", 1)];
    if let Some(squared) = impact.free_swing.law.frequency_squared() {
        lines.push(format!("\\omega^{{2}} &= {}", law(squared, &impact.free_swing)));
    }
    for (label, value) in [
        ("A", setup.amplitude),
        ("x_{c}", setup.barrier),
        ("\\gamma", setup.stiffness),
    ] {
        lines.push(format!("{label} &= {}", scientific(value)));
    }
    let mut text = String::from("% gamma: ");
    let _ = writeln!(text, "{}", setup.stiffness_source);
    for (title, phases) in [
        ("contact speed from the one-term motion", &impact.paper),
        ("contact speed from the energy", &impact.energy),
    ] {
        lines.push(format!("&\\text{{{title}:}}"));
        lines.extend(phases.phases.iter().flat_map(phase));
    }
    let _ = writeln!(text, "\\begin{{align*}}\n{}\n\\end{{align*}}", lines.join(" \\\\\n"));
    text.push_str("\\begin{tabular}{lrrrrr}\n & Runge--Kutta & paper & error & energy & error \\\\\n\\hline\n");
    for quantity in impact.quantities() {
        let percent = |error: f64| format!("${}\\,\\%$", scientific((1e5 * error).round() / 1e3));
        let _ = writeln!(
            text,
            "{} & ${}$ & ${}$ & {} & ${}$ & {} \\\\",
            quantity.name,
            scientific(quantity.runge_kutta),
            scientific(quantity.paper),
            percent(quantity.paper_error()),
            scientific(quantity.energy),
            percent(quantity.energy_error())
        );
    }
    text.push_str("\\end{tabular}\n");
    let name = |column| impact.verdict(column, tolerance).name();
    let _ = writeln!(
        text,
        "% verdict: paper {}, energy {}",
        name(ContactSpeed::Paper),
        name(ContactSpeed::Energy)
    );
    text
}

/// The name of a phase and when it is, and its closed form.
fn phase(phase: &Phase) -> [String; 2] {
    let clock = match phase.name {
        "contact" => "(t - t_{1})",
        "return" => "(t - t_{2})",
        _ => "t",
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
            let centre = crate::decimal::significant(centre, 9);
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

pub(super) const NOTATION: Notation = Notation {
    wave: |function, k| match k {
        1 => format!("\\{function} \\theta"),
        _ => format!("\\{function} {k}\\theta"),
    },
    times: " ",
    brackets: ["\\left(", "\\right)"],
};

pub(super) fn waves(series: &FourierSeries<Polynomials>, solution: &Solution) -> Vec<String> {
    terms::waves(series, |coefficient| law(coefficient, solution), &NOTATION)
}

/// The motion, one harmonic a line.
fn motion(solution: &Solution) -> Vec<String> {
    let coordinate = solution.coordinate();
    let waves = waves(&solution.displacement, solution);
    let mut lines = terms::lines(&waves, &format!("{coordinate}(t) &= "), "&\\quad ");
    lines.push("\\theta &= \\omega t".to_owned());
    lines
}

/// Every method in one table; those that do not apply stand in comments below it.
pub fn comparison(comparison: &Comparison) -> String {
    let at = comparison.at.iter();
    let at: Vec<String> = at
        .map(|(name, value)| format!("{} = {}", symbol(name), expression(value)))
        .collect();
    let mut text = format!(
        "% {}; true omega = {}\n\\begin{{tabular}}{{lrrrl}}\n\\hline\n",
        comparison.equation,
        comparison.true_frequency.map_or_else(
            || format!(
                "not known: {}",
                comparison.reason.as_ref().map(ToString::to_string).unwrap_or_default()
            ),
            decimal
        )
    );
    let place = if at.is_empty() {
        String::new()
    } else {
        format!(" at ${}$", at.join(", "))
    };
    let _ = writeln!(
        text,
        "method & $\\omega${place} & error in \\% & deviation in \\% & formula \\\\\n\\hline"
    );
    for row in &comparison.rows {
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
        let frequency = row
            .frequency
            .map_or("--".to_owned(), |value| format!("${}$", scientific(value)));
        let _ = writeln!(
            text,
            "{} & {frequency} & {} & {} & {} \\\\",
            row.solution.title(),
            percent(row.relative_error),
            percent(row.max_deviation),
            with_hbar(row),
        );
    }
    text.push_str("\\hline\n\\end{tabular}\n");
    for refused in &comparison.refused {
        let _ = writeln!(text, "% not applicable: {}: {}", refused.method.title(), refused.reason);
    }
    for line in &comparison.validity {
        let _ = writeln!(text, "% {line}");
    }
    text
}

/// The formula of a row, and the hbar with which it was evaluated.
fn with_hbar(row: &Row) -> String {
    let formula = formula(&row.solution);
    match row.chosen_hbar() {
        None => formula,
        Some((name, value)) => {
            let value = scientific_text(&significant(value, 6));
            let formula = formula.strip_suffix('$').unwrap_or(&formula);
            format!("{formula}, \\; {} = {value}$", symbol(name))
        }
    }
}

/// The law in one line, with the definitions it needs.
fn formula(solution: &Solution) -> String {
    let (text, used) = if let Some(squared) = solution.law.frequency_squared() {
        (format!("\\omega^{{2}} = {}", law(squared, solution)), squared.symbols())
    } else if let Some(form) = solution.law.closed_form() {
        if solution.numerical {
            return "closed form, rounded coefficients".to_owned();
        }
        let name = if form.squared { "\\omega^{2}" } else { "\\omega" };
        (format!("{name} = {}", expression(&form.value)), form.value.symbols())
    } else if let Some(frequency) = solution.law.frequency() {
        (format!("\\omega = {}", law(frequency, solution)), frequency.symbols())
    } else if let Some(relation) = solution.law.relation() {
        (format!("0 = {}", law(relation, solution)), relation.symbols())
    } else {
        return "by numbers".to_owned();
    };
    let definitions = solution.definitions_behind(used).into_iter().map(|definition| {
        format!(
            ", \\; {} = {}",
            symbol(definition.symbol),
            constant(&definition.meaning)
        )
    });
    format!("${text}{}$", definitions.collect::<String>())
}

/// Running text inside `\\text{...}`.
pub(super) fn words(text: &str) -> String {
    let mut escaped = String::new();
    for letter in text.chars() {
        match letter {
            '%' | '&' | '#' | '$' | '_' | '{' | '}' => escaped.extend(['\\', letter]),
            '^' => escaped.push_str("\\^{}"),
            '<' | '>' => escaped.extend(['$', letter, '$']),
            '\\' | '~' => escaped.push(' '),
            _ => escaped.push(letter),
        }
    }
    escaped
}

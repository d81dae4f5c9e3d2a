//! Results as text that reads like a textbook. Formulas print so that they can be typed back in.

use std::fmt::Write as _;

use crate::exact::Polynomial;
use crate::expr::Expr;
use crate::solution::Solution;
use crate::verify::{Verdict, Verification};

/// Six significant digits or more, as people write them: `0.860608`, `3.0407e7`, `-1.49`.
pub fn decimal(value: f64) -> String {
    significant(value, 6)
}

/// `value` with so many significant digits, without trailing zeros.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    if (-4..digits as i32).contains(&exponent) {
        let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
        return trimmed(&format!("{value:.decimals$}"));
    }
    format!("{}e{exponent}", trimmed(mantissa))
}

/// A signed relative error in percent: `-1.49 %`.
pub fn percent(error: f64) -> String {
    let digits = significant(100.0 * error.abs(), 3);
    format!("{}{digits} %", if error < 0.0 { "-" } else { "+" })
}

/// The derived formula, and the verdict where it was judged.
pub fn solution(solution: &Solution, verification: Option<&Verification>, tolerance: f64) -> String {
    let mut text = format!("{}\n\n", solution.equation);
    let _ = writeln!(
        text,
        "{} to order {} in {}, {}",
        solution.method.title(),
        solution.order,
        solution.small_parameter,
        solution.amplitude
    );
    text.push('\n');
    let mut law = |name: &str, law: &Option<Polynomial>| {
        if let Some(law) = law {
            let _ = writeln!(text, "  {name:<8}= {law}");
        }
    };
    law("omega^2", &solution.frequency_squared);
    law("omega", &solution.frequency);
    if let Some(amplitude) = &solution.limit_cycle {
        let _ = writeln!(text, "\n  limit cycle of amplitude {} = {amplitude}", solution.amplitude.symbol());
    }
    let _ = writeln!(text, "\n{}", motion(solution));
    for definition in &solution.definitions {
        let _ = writeln!(text, "  {} = {}", definition.symbol, definition.meaning);
    }
    text.push_str("\nValidity\n");
    for line in &solution.validity {
        let _ = writeln!(text, "  {line}");
    }
    if let Some(verification) = verification {
        text.push('\n');
        text.push_str(&self::verification(verification, tolerance));
    }
    text
}

/// The motion, one harmonic a line.
fn motion(solution: &Solution) -> String {
    let mut lines = Vec::new();
    for (k, cosine, sine) in solution.displacement.harmonics() {
        for (function, coefficient) in [("cos", cosine), ("sin", sine)] {
            if num_traits::Zero::is_zero(&coefficient) {
                continue;
            }
            let wave = match k {
                0 => String::new(),
                1 => format!("*{function}(theta)"),
                _ => format!("*{function}({k}*theta)"),
            };
            let expression = Expr::from(&coefficient);
            let single = expression.terms().len() == 1;
            let text = expression.to_string();
            let (sign, text) = match (single, text.strip_prefix('-')) {
                (true, Some(rest)) => ("-", rest.to_owned()),
                (true, None) => ("+", text),
                (false, _) if k == 0 => ("+", text),
                (false, _) => ("+", format!("({text})")),
            };
            let bare = text == "1" && k > 0;
            let term = if bare { wave.trim_start_matches('*').to_owned() } else { format!("{text}{wave}") };
            lines.push(match (lines.is_empty(), sign) {
                (true, "+") => format!("  x(t) = {term}").replacen('x', solution_coordinate(solution), 1),
                (true, _) => format!("  x(t) = -{term}").replacen('x', solution_coordinate(solution), 1),
                (false, _) => format!("         {sign} {term}"),
            });
        }
    }
    lines.push("         theta = omega*t".to_owned());
    lines.join("\n")
}

fn solution_coordinate(solution: &Solution) -> &str {
    solution.equation.split('\'').next().unwrap_or("x")
}

/// The verdict, number by number.
pub fn verification(verification: &Verification, tolerance: f64) -> String {
    let at: Vec<String> = verification.at.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    let mut text = match at.is_empty() {
        true => "Judged against the true motion\n".to_owned(),
        false => format!("Judged against the true motion at {}\n", at.join(", ")),
    };
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<18}{value}");
    };
    line("omega", verification.frequency.map_or("not real: omega^2 <= 0".to_owned(), decimal));
    line("true omega", decimal(verification.true_frequency));
    if let Some(error) = verification.relative_error {
        line("relative error", percent(error));
    }
    if let Some(deviation) = verification.max_deviation {
        line("largest deviation", format!("{} % of the amplitude over one period", significant(100.0 * deviation, 3)));
    }
    if let Some(residual) = verification.residual {
        line("residual", format!("{} % of the force (rms)", significant(100.0 * residual, 3)));
    }
    line("slope of the error", verification.slope.map_or("hidden by rounding".to_owned(), |slope| format!(" {slope:.2}")));
    let verdict = if verification.verdict == Verdict::Pass { "pass" } else { "fail" };
    line("verdict", format!("{verdict} (|relative error| <= {} %)", significant(100.0 * tolerance, 3)));
    text
}

//! Results as text that reads like a textbook. Formulas print so that they can be typed back in.

use std::fmt::Write as _;

use num_traits::One;

use crate::contact::phases::Column;
use crate::decimal::{decimal, significant};
use crate::exact::polynomial::Monomial;
use crate::exact::rational::to_f64;
use crate::exact::{Polynomial, Rational};
use crate::impact::Impact;
use crate::solution::Solution;
use crate::symbol::Symbol;
use crate::verify::{Verdict, Verification};

/// A signed relative error in percent: `-1.49 %`; what is rounding is called that.
pub fn percent(error: f64) -> String {
    if error.abs() < 1e-9 {
        return "< 1e-7 %".to_owned();
    }
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
        solution.order_counts(),
        solution.amplitude
    );
    text.push('\n');
    let mut law = |name: &str, law: &Option<Polynomial>| {
        if let Some(law) = law {
            let _ = writeln!(text, "  {name:<8}= {}", by_order(law, solution));
        }
    };
    law("omega^2", &solution.frequency_squared);
    law("omega", &solution.frequency);
    if let (None, Some(relation)) = (&solution.frequency_squared, &solution.relation) {
        let _ = writeln!(
            text,
            "  0       = {}",
            ordered(relation, solution.numerical, |monomial| -monomial
                .exponent(Symbol::new("omega")))
        );
    }
    if let Some(closed_form) = &solution.closed_form {
        let _ = writeln!(text, "  {closed_form}");
    }
    if let Some(amplitude) = &solution.limit_cycle {
        let _ = writeln!(
            text,
            "\n  limit cycle of amplitude {} = {}",
            solution.amplitude.symbol(),
            by_order(amplitude, solution)
        );
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

/// A polynomial with the lowest power of the small parameter first.
pub fn by_order(polynomial: &Polynomial, solution: &Solution) -> String {
    ordered(polynomial, solution.numerical, |monomial| {
        monomial.exponent(solution.small_parameter)
    })
}

fn ordered(polynomial: &Polynomial, numerical: bool, key: impl Fn(&Monomial) -> i32) -> String {
    let mut terms: Vec<_> = polynomial.terms().collect();
    terms.sort_by_key(|(monomial, _)| key(monomial));
    let mut text = String::new();
    for (monomial, coefficient) in terms {
        let term = single_term(monomial, coefficient, numerical);
        match (text.is_empty(), term.strip_prefix('-')) {
            (true, _) => text.push_str(&term),
            (false, Some(rest)) => text.extend([" - ", rest]),
            (false, None) => text.extend([" + ", &term]),
        }
    }
    if text.is_empty() { "0".to_owned() } else { text }
}

/// One term; rounded coefficients print as decimals.
fn single_term(monomial: &Monomial, coefficient: &Rational, numerical: bool) -> String {
    let term = |number: Rational| Polynomial::term(monomial.clone(), number).to_string();
    if !numerical || coefficient.is_integer() {
        return term(coefficient.clone());
    }
    let number = decimal(to_f64(coefficient));
    match monomial.factors().is_empty() {
        true => number,
        false => format!("{number}*{}", term(Rational::one())),
    }
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
            let single = coefficient.single_term().is_some();
            let text = by_order(&coefficient, solution);
            let (sign, text) = match (single, text.strip_prefix('-')) {
                (true, Some(rest)) => ("-", rest.to_owned()),
                (true, None) => ("+", text),
                (false, _) if k == 0 => ("+", text),
                (false, _) => ("+", format!("({text})")),
            };
            let bare = text == "1" && k > 0;
            let term = if bare {
                wave.trim_start_matches('*').to_owned()
            } else {
                format!("{text}{wave}")
            };
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
    let at: Vec<String> = verification
        .at
        .iter()
        .map(|(name, value)| format!("{name} = {value}"))
        .collect();
    let mut text = match at.is_empty() {
        true => "Judged against the true motion\n".to_owned(),
        false => format!("Judged against the true motion at {}\n", at.join(", ")),
    };
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<20}{value}");
    };
    line(
        "omega",
        verification
            .frequency
            .map_or("not real: omega^2 <= 0".to_owned(), decimal),
    );
    line("true omega", decimal(verification.true_frequency));
    if let Some(error) = verification.relative_error {
        line("relative error", percent(error));
    }
    if let Some(deviation) = verification.max_deviation {
        line(
            "largest deviation",
            format!(
                "{} % of the amplitude over one period",
                significant(100.0 * deviation, 3)
            ),
        );
    }
    if let Some(residual) = verification.residual {
        line(
            "residual",
            format!("{} % of the force (rms)", significant(100.0 * residual, 3)),
        );
    }
    line(
        "slope of the error",
        verification
            .slope
            .map_or("hidden by rounding".to_owned(), |slope| format!("{slope:.2}")),
    );
    let verdict = if verification.verdict == Verdict::Pass {
        "pass"
    } else {
        "fail"
    };
    line(
        "verdict",
        format!(
            "{verdict} (|relative error| <= {} %)",
            significant(100.0 * tolerance, 3)
        ),
    );
    text
}

/// The whole story of an impact.
pub fn impact(impact: &Impact, tolerance: f64) -> String {
    let setup = &impact.setup;
    let mut text = format!("{}\n", impact.equation);
    let _ = writeln!(
        text,
        "x(0) = -A, x'(0) = 0: released from rest, towards a barrier at xc\n"
    );
    let _ = writeln!(text, "  A     = {}", decimal(setup.amplitude));
    let _ = writeln!(text, "  xc    = {}", decimal(setup.barrier));
    let _ = writeln!(
        text,
        "  gamma = {}   ({})",
        decimal(setup.stiffness),
        setup.stiffness_source
    );
    let law = impact
        .law
        .frequency_squared
        .as_ref()
        .map(ToString::to_string)
        .unwrap_or_default();
    let _ = writeln!(
        text,
        "\nThe law of the free swing, {} to order {} in A",
        impact.law.method.title(),
        impact.law.order
    );
    let _ = writeln!(text, "  {}", impact.law.equation);
    let _ = writeln!(text, "  omega^2 = {law}");
    let _ = writeln!(
        text,
        "  omega   = {}   (A = {})",
        decimal(impact.frequency()),
        decimal(setup.amplitude)
    );
    for (title, phases) in [
        (
            "The paper's way: every join continuous, contact speed from the one-term motion",
            &impact.paper,
        ),
        (
            "With the contact speed from the energy, v = sqrt(2*(cos(xc) - cos(A)))",
            &impact.energy,
        ),
    ] {
        let _ = writeln!(text, "\n{title}");
        let line = phases.line;
        let constant = phases.line.q(setup.barrier);
        let _ = writeln!(
            text,
            "  elastic force gamma*({}*x {} {}), fitted by {} over the depth {}",
            decimal(line.slope),
            if constant < 0.0 { '+' } else { '-' },
            decimal(constant.abs()),
            setup.rule,
            decimal(phases.fitted_depth)
        );
        for (phase, conditions) in
            phases
                .phases
                .iter()
                .zip(["x = -A to x = xc", "x = xc to x = xc", "x = xc to x = -A"])
        {
            let times = format!("{} <= t <= {}", decimal(phase.start), decimal(phase.end));
            let _ = writeln!(text, "  {:<9} {conditions},  {times}", phase.name);
            let _ = writeln!(text, "            {}", phase.closed_form());
        }
        if phases.velocity_jump != 0.0 {
            let _ = writeln!(
                text,
                "  the velocity jumps by {} at either join",
                decimal(phases.velocity_jump)
            );
        }
    }
    text.push_str("\nBeside Runge-Kutta on the original equation\n");
    let _ = writeln!(
        text,
        "  {:<18}{:>12}{:>12}{:>14}{:>22}",
        "", "Runge-Kutta", "paper", "", "energy"
    );
    for quantity in impact.quantities() {
        let _ = writeln!(
            text,
            "  {:<18}{:>12}{:>12}{:>12}{:>12}{:>12}",
            quantity.name,
            decimal(quantity.runge_kutta),
            decimal(quantity.paper),
            percent(quantity.paper_error()),
            decimal(quantity.energy),
            percent(quantity.energy_error())
        );
    }
    let relative = |deviation: f64| format!("{} %", significant(100.0 * deviation / setup.amplitude, 3));
    let (paper, energy) = (
        relative(impact.paper_deviation.total),
        relative(impact.energy_deviation.total),
    );
    let _ = writeln!(
        text,
        "  {:<18}{:>12}{paper:>12}{:>12}{energy:>12}",
        "largest deviation", "", ""
    );
    let drift = 10_f64.powf(impact.truth.energy_drift.max(1e-15).log10().ceil());
    let _ = writeln!(
        text,
        "  Runge-Kutta keeps the energy to {drift:e} of the kinetic energy at touch"
    );
    let name = |verdict| if verdict == Verdict::Pass { "pass" } else { "fail" };
    let _ = writeln!(
        text,
        "  verdict (every number within {} %): paper {}, energy {}",
        significant(100.0 * tolerance, 3),
        name(impact.verdict(Column::Paper, tolerance)),
        name(impact.verdict(Column::Energy, tolerance))
    );
    text
}

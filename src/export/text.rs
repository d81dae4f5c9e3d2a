//! Results as text that reads like a textbook. Formulas print so that they can be typed back in.

mod comparison;

use std::fmt::Write as _;

use num_traits::One;

pub use comparison::comparison;

pub use super::steps::text as steps;
use crate::decimal::{decimal, significant, significant_fraction};
use crate::derivation::NOTATION;
use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, Polynomials, Rational};
use crate::impact::{ContactSpeed, Impact};
use crate::method::homotopy_analysis::HBAR;
use crate::series::FourierSeries;
use crate::series::terms;
use crate::solution::{LeadingCycle, LimitCycle, Solution, constant_in_words};
use crate::symbol::Symbol;
use crate::verify::Verification;

/// A signed relative error in percent: `-1.49 %`; what is rounding is called that.
pub fn percent(error: f64) -> String {
    if error.abs() < 1e-9 {
        return "< 1e-7 %".to_owned();
    }
    let digits = significant(100.0 * error.abs(), 3);
    format!("{}{digits} %", if error < 0.0 { "-" } else { "+" })
}

/// A size in percent: `2.86 %`; what is rounding is called that.
fn size_in_percent(size: f64) -> String {
    match size < 1e-9 {
        true => "< 1e-7 %".to_owned(),
        false => format!("{} %", significant(100.0 * size, 3)),
    }
}

/// The derived formula, and the verdict where it was judged.
pub fn solution(solution: &Solution, verification: Option<&Verification>, tolerance: f64) -> String {
    let mut text = format!("{}\n\n", solution.equation);
    let _ = writeln!(text, "{}, {}", solution.title(), solution.amplitude);
    text.push('\n');
    let mut law = |name: &str, law: Option<&Polynomial>| {
        if let Some(law) = law {
            let _ = writeln!(text, "  {name:<8}= {}", by_order(law, solution));
        }
    };
    law("omega^2", solution.law.frequency_squared());
    law("omega", solution.law.frequency());
    if let (None, Some(relation)) = (solution.law.frequency_squared(), solution.law.relation()) {
        let _ = writeln!(
            text,
            "  0       = {}",
            ordered(relation, solution.numerical, |monomial| -monomial
                .exponent(Symbol::new("omega")))
        );
    }
    if let Some(closed_form) = solution.law.closed_form() {
        let _ = writeln!(text, "  {closed_form}");
    }
    if let Some(cycle) = &solution.limit_cycle {
        let _ = writeln!(
            text,
            "\n  limit cycle of amplitude {} = {}",
            solution.amplitude.symbol(),
            by_order(&cycle.amplitude, solution)
        );
        for line in other_cycles(cycle, solution) {
            let _ = writeln!(text, "  {line}");
        }
    }
    for line in solution.law.quadrature().into_iter().flatten() {
        let _ = writeln!(text, "  {line}");
    }
    if let Some(system) = solution.law.system() {
        let names: Vec<&str> = system.unknowns.iter().map(|name| name.name()).collect();
        let _ = writeln!(text, "  for {}:", names.join(", "));
        for equation in &system.equations {
            let _ = writeln!(text, "  0 = {equation}");
        }
    }
    match solution.displacement.is_zero() {
        true => text.push_str("\n  the motion follows by quadrature of the energy\n"),
        false => {
            let _ = writeln!(text, "\n{}", motion(solution));
        }
    }
    for definition in &solution.definitions {
        let _ = writeln!(text, "  {} = {}", definition.symbol, definition.meaning_in_words());
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

/// Where an equation has several limit cycles: all of them, to leading order.
pub fn other_cycles(cycle: &LimitCycle, solution: &Solution) -> Vec<String> {
    if cycle.cycles.len() < 2 {
        return vec![];
    }
    let symbol = solution.amplitude.symbol();
    let small: Vec<&str> = solution.small_parameters().map(|name| name.name()).collect();
    let head = format!(
        "cycle {} of {}; for {} -> 0:",
        cycle.number,
        cycle.cycles.len(),
        small.join(", ")
    );
    let line = |(k, each): (usize, &LeadingCycle)| {
        let own = if k + 1 == cycle.number { "*" } else { " " };
        let amplitude = &each.amplitude;
        let value = match amplitude.as_number() {
            Some(_) => String::new(),
            None => {
                let value = amplitude.evaluate(&std::collections::BTreeMap::new());
                value.map_or_else(|_| String::new(), |value| format!(" = {}", decimal(value)))
            }
        };
        let exact = constant_in_words(amplitude);
        format!("{own} {}  {symbol} = {exact}{value}, {}", k + 1, each.stability())
    };
    std::iter::once(head)
        .chain(cycle.cycles.iter().enumerate().map(line))
        .collect()
}

/// A polynomial with the lowest power of the small parameter first.
pub fn by_order(polynomial: &Polynomial, solution: &Solution) -> String {
    ordered(polynomial, solution.numerical, |monomial| solution.order_of(monomial))
}

fn ordered(polynomial: &Polynomial, numerical: bool, key: impl Fn(&Monomial) -> i32) -> String {
    terms::polynomial(polynomial, key, |monomial, coefficient| {
        single_term(monomial, coefficient, numerical)
    })
}

/// One term; rounded coefficients print as decimals.
fn single_term(monomial: &Monomial, coefficient: &Rational, numerical: bool) -> String {
    let term = |number: Rational| Polynomial::term(monomial.clone(), number).to_string();
    if !numerical || coefficient.is_integer() {
        return term(coefficient.clone());
    }
    let number = significant_fraction(coefficient, 6);
    match monomial.factors().is_empty() {
        true => number,
        false => format!("{number}*{}", term(Rational::one())),
    }
}

fn waves(series: &FourierSeries<Polynomials>, solution: &Solution) -> Vec<String> {
    terms::waves(series, |coefficient| by_order(coefficient, solution), &NOTATION)
}

/// The motion, one harmonic a line.
fn motion(solution: &Solution) -> String {
    let name = solution.coordinate();
    let mut lines = terms::lines(
        &waves(&solution.displacement, solution),
        &format!("  {name}(t) = "),
        "         ",
    );
    lines.push("         theta = omega*t".to_owned());
    lines.join("\n")
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
        verification.frequency.map_or_else(
            || {
                verification
                    .reason
                    .as_ref()
                    .map(ToString::to_string)
                    .unwrap_or_default()
            },
            decimal,
        ),
    );
    line("true omega", decimal(verification.true_frequency));
    if let Some(error) = verification.relative_error {
        line("relative error", percent(error));
    }
    match verification.error_of_omega {
        Some(other)
            if verification
                .relative_error
                .is_none_or(|error| (other - error).abs() > 1e-9) =>
        {
            line(
                "judged on",
                format!(
                    "the root of omega^2; the series of omega itself errs by {}",
                    percent(other)
                ),
            )
        }
        _ => line("judged on", verification.judged_on.to_owned()),
    }
    if let Some(deviation) = verification.max_deviation {
        line(
            "largest deviation",
            format!("{} of the amplitude over one period", size_in_percent(deviation)),
        );
    }
    if let Some(residual) = verification.residual {
        line("residual", format!("{} of the force (rms)", size_in_percent(residual)));
    }
    line(
        "slope of the error",
        verification
            .slope
            .map_or("hidden by rounding".to_owned(), |slope| format!("{slope:.2}")),
    );
    for (name, value) in &verification.chosen {
        let how = if name.name().starts_with(HBAR) {
            " (least squared residual)"
        } else {
            ""
        };
        line(name.name(), format!("{}{how}", significant(*value, 6)));
    }
    for range in &verification.ranges {
        let mark = if range.outside { "  <- outside" } else { "" };
        line("range", format!("{}{mark}", range.text));
    }
    let verdict = verification.verdict.name();
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
        .free_swing
        .law
        .frequency_squared()
        .map(ToString::to_string)
        .unwrap_or_default();
    let _ = writeln!(
        text,
        "\nThe law of the free swing, {} to order {} in A",
        impact.free_swing.method.title(),
        impact.free_swing.order
    );
    let _ = writeln!(text, "  {}", impact.free_swing.equation);
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
    let _ = writeln!(
        text,
        "  verdict (every number within {} %): paper {}, energy {}",
        significant(100.0 * tolerance, 3),
        impact.verdict(ContactSpeed::Paper, tolerance).name(),
        impact.verdict(ContactSpeed::Energy, tolerance).name()
    );
    for (column, title) in [(ContactSpeed::Paper, "paper"), (ContactSpeed::Energy, "energy")] {
        for (errors, cause) in impact.shortcomings(column, tolerance) {
            let errors: Vec<String> = errors
                .iter()
                .map(|(name, error)| format!("{name} {}", percent(*error)))
                .collect();
            let _ = writeln!(text, "    {title:<8}{}: {cause}", errors.join(", "));
        }
    }
    text
}

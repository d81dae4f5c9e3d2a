//! The derivation of an answer, in steps that can be followed by hand, as text and as LaTeX.

use std::fmt::Write as _;

use num_traits::Zero;

use super::latex::{self, symbol};
use crate::derivation::{
    AmplitudeCondition, Condition, DerivationFormula, DerivationLine, DerivativeTerm, NOTATION,
    Step,
};
use crate::exact::{Polynomial, Polynomials};
use crate::expr::Expr;
use crate::series::FourierSeries;
use crate::series::terms;
use crate::solution::{Counts, Solution};
use crate::symbol::letters::FREQUENCY;
use crate::symbol::{Symbol, fresh, fresh_stem};

/// Whether all quantities are in units of omega, and `p` marks the orders.
fn is_homotopy(solution: &Solution) -> bool {
    solution.method.counts() == Counts::PowersOfBookkeeping
}

/// The factor of the orders `y_n`: the amplitude, or that of a limit cycle before its corrections.
fn unit(solution: &Solution) -> Symbol {
    let leading = solution.steps.first().and_then(|step| step.amplitude.as_ref());
    leading.map_or(solution.amplitude.symbol(), |condition| condition.unknown)
}

/// The symbols of the orders and of the corrections of the frequency: `y` and `W`, or others if the
/// equation uses these names.
fn letters(solution: &Solution) -> [String; 2] {
    ["y", "W"].map(|letter| fresh_stem(letter, &solution.names()))
}

/// A symbol with its order as an index, in LaTeX.
fn indexed(letter: &str, order: u32) -> String {
    symbol(Symbol::new(&format!("{letter}{order}")))
}

/// The derivation as text: the orders of an expansion, or the lines of any other method; empty if
/// there is nothing to show.
///
/// ```
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// assert!(lindstedt::export::text::steps(&solution).starts_with("Derivation\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn text(solution: &Solution) -> String {
    let _letters = solution.letters().in_force();
    if solution.steps.is_empty() && solution.derivation.is_empty() {
        return String::new();
    }
    let mut text = String::from("Derivation\n");
    if !solution.steps.is_empty() {
        let (name, unit, [y, w]) = (solution.coordinate(), unit(solution), letters(solution));
        let (p, omega0) = (fresh("p", &solution.names()), solution.linear_frequency_name());
        let phase = solution.phase();
        let frame = match is_homotopy(solution) {
            true => [
                format!(
                    "{name} = {unit}*({y}0 + {p}*{y}1 + {p}^2*{y}2 + ...), {phase} = {FREQUENCY}*t, derivatives in {phase}"
                ),
                format!(
                    "{omega0}^2 = {FREQUENCY}^2*(1 - {p}*{w}1 - {p}^2*{w}2 - ...); the nonlinear terms stand at {p}, all in units of {FREQUENCY}^2"
                ),
            ],
            false => [
                format!(
                    "{name} = {unit}*({y}0 + {y}1 + {y}2 + ...), {phase} = {FREQUENCY}*t, derivatives in {phase}"
                ),
                format!(
                    "{FREQUENCY}^2 = {omega0}^2*(1 + {w}1 + {w}2 + ...); each order carries its power of the small parameter"
                ),
            ],
        };
        for line in frame {
            let _ = writeln!(text, "  {line}");
        }
    }
    for line in &solution.derivation {
        let _ = writeln!(text, "  {line}");
    }
    for step in &solution.steps {
        for line in order_as_text(step, solution) {
            let _ = writeln!(text, "{line}");
        }
    }
    text
}

fn order_as_text(step: &Step, solution: &Solution) -> Vec<String> {
    let n = step.order;
    let phase = solution.phase();
    let [y, w] = letters(solution);
    let waves = |series: &FourierSeries<Polynomials>| {
        terms::sum(terms::waves(
            series,
            |coefficient| solution.ordered(coefficient).to_string(),
            &NOTATION,
            phase,
        ))
    };
    let conditions: Vec<String> = step
        .conditions
        .iter()
        .map(|condition| condition_as_text(*condition, &format!("{y}{n}"), phase))
        .collect();
    let mut lines = vec![format!("\n  order {n}")];
    if n == 0 {
        lines.push(format!("    {y}0'' + {y}0 = 0"));
    } else {
        let secular = secular_terms(
            step,
            |resonance| solution.ordered(resonance).to_string(),
            format!("{w}{n}"),
        );
        let driven = terms::waves(
            &step.right_side(),
            |coefficient| solution.ordered(coefficient).to_string(),
            &NOTATION,
            phase,
        );
        let resonant = match step.resonance.is_zero() {
            true => format!("{secular}*cos({phase})"),
            false => format!("({secular})*cos({phase})"),
        };
        lines.push(format!(
            "    {y}{n}'' + {y}{n} = {}",
            terms::sum(driven.into_iter().chain([resonant]))
        ));
        lines.push(format!("    no secular cos({phase}):  {secular} = 0"));
        if !step.resonance.is_zero() {
            lines.push(format!(
                "    fixes               {w}{n} = {}",
                solution.ordered(&step.correction)
            ));
        }
    }
    lines.push(format!("    with                {}", conditions.join(", ")));
    if let Some(AmplitudeCondition { sine, unknown, value }) = &step.amplitude {
        lines.push(format!(
            "    no secular sin({phase}) at order {}:  {} = 0",
            n + 1,
            solution.ordered(sine)
        ));
        let what = match n {
            0 => "the amplitude of the limit cycle".to_owned(),
            _ => format!("the cos({phase}) of {y}{n}"),
        };
        lines.push(format!("    fixes               {unknown} = {value}, {what}"));
    }
    lines.push(format!("    {y}{n} = {}", waves(&step.displacement)));
    lines
}

/// `resonance + W_n`, the coefficient that must vanish.
fn secular_terms(step: &Step, law: impl Fn(&Polynomial) -> String, correction: String) -> String {
    match step.resonance.is_zero() {
        true => correction,
        false => format!("{} + {correction}", law(&step.resonance)),
    }
}

fn condition_as_text(condition: Condition, y: &str, phase: Symbol) -> String {
    match condition {
        Condition::Position(value) => format!("{y}(0) = {value}"),
        Condition::AtRest => format!("{y}'(0) = 0"),
        Condition::NoCosine => format!("no cos({phase}) in {y}"),
        Condition::NoSine => format!("no sin({phase}) in {y}"),
    }
}

/// The derivation as LaTeX.
///
/// ```
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// assert!(lindstedt::export::latex::steps(&solution).contains(r"\omega^{2}"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn latex(solution: &Solution) -> String {
    let _letters = solution.letters().in_force();
    match rows(solution) {
        rows if rows.is_empty() => String::new(),
        rows => format!("\\begin{{align*}}\n{}\n\\end{{align*}}\n", rows.join(" \\\\\n")),
    }
}

/// The derivation as rows of `align*`; empty if there is nothing to show.
pub(super) fn rows(solution: &Solution) -> Vec<String> {
    let mut lines = Vec::new();
    if !solution.steps.is_empty() {
        let (name, unit, omega) =
            (symbol(solution.coordinate()), symbol(unit(solution)), symbol(FREQUENCY));
        let [y, w] = letters(solution);
        let [p, omega0] =
            [fresh("p", &solution.names()), solution.linear_frequency_name()].map(symbol);
        let ([y0, y1, y2], [w1, w2]) =
            ([0, 1, 2].map(|n| indexed(&y, n)), [1, 2].map(|n| indexed(&w, n)));
        let (motion, squared) = match is_homotopy(solution) {
            true => (
                format!("{y0} + {p} {y1} + {p}^{{2}} {y2} + \\dots"),
                format!(
                    "{omega0}^{{2}} &= {omega}^{{2}} \\left(1 - {p} {w1} - {p}^{{2}} {w2} - \\dots\\right)"
                ),
            ),
            false => (
                format!("{y0} + {y1} + {y2} + \\dots"),
                format!("{omega}^{{2}} &= {omega0}^{{2}} \\left(1 + {w1} + {w2} + \\dots\\right)"),
            ),
        };
        lines.push(format!(
            "{name} &= {unit} \\left({motion}\\right), \\qquad {} = {omega} t",
            symbol(solution.phase())
        ));
        lines.push(squared);
    }
    lines.extend(solution.derivation.iter().flat_map(line_as_latex));
    for step in &solution.steps {
        lines.extend(order_as_latex(step, solution));
    }
    latex::rows::aligned(&lines)
}

fn order_as_latex(step: &Step, solution: &Solution) -> Vec<String> {
    let n = step.order;
    let phase = symbol(solution.phase());
    let [y, w] = letters(solution);
    let (y, w) = (indexed(&y, n), indexed(&w, n));
    let law = |polynomial: &Polynomial| latex::sum(&solution.ordered(polynomial));
    let conditions: Vec<String> = step
        .conditions
        .iter()
        .map(|condition| condition_as_latex(*condition, &y, &phase))
        .collect();
    let conditions = conditions.join(", \\quad ");
    let mut lines = Vec::new();
    if n == 0 {
        lines.push(format!("{y}'' + {y} &= 0"));
    } else {
        let secular = secular_terms(step, law, w.to_string());
        let resonant = match step.resonance.is_zero() {
            true => format!("{secular} \\cos {phase}"),
            false => format!("\\left({secular}\\right) \\cos {phase}"),
        };
        let driven = latex::waves(&step.right_side(), solution);
        let right_side = terms::sum(driven.into_iter().chain([resonant]));
        lines.push(format!("{y}'' + {y} &= {right_side}"));
        let fixes = match step.resonance.is_zero() {
            true => String::new(),
            false => format!(" \\quad\\Rightarrow\\quad {w} = {}", law(&step.correction)),
        };
        lines.push(format!("{secular} &= 0{fixes}"));
    }
    if let Some(condition) = &step.amplitude {
        lines.push(format!(
            "{} &= 0 \\quad\\Rightarrow\\quad {} = {} \\qquad \\text{{(no secular $\\sin {phase}$ at order {})}}",
            law(&condition.sine),
            symbol(condition.unknown),
            latex::expression(&condition.value),
            n + 1
        ));
    }
    let displacement = terms::sum(latex::waves(&step.displacement, solution));
    lines.push(format!("{y} &= {displacement}, \\qquad {conditions}"));
    lines
}

fn condition_as_latex(condition: Condition, y: &str, phase: &str) -> String {
    match condition {
        Condition::Position(value) => format!("{y}(0) = {value}"),
        Condition::AtRest => format!("{y}'(0) = 0"),
        Condition::NoCosine => format!("\\text{{no $\\cos {phase}$ in ${y}$}}"),
        Condition::NoSine => format!("\\text{{no $\\sin {phase}$ in ${y}$}}"),
    }
}

/// A line of a derivation as rows of `align*`: its words above its equation.
pub(super) fn line_as_latex(line: &DerivationLine) -> Vec<String> {
    let mut rows = Vec::new();
    if !line.words.is_empty() {
        let colon = if line.equal.is_empty() { "" } else { ":" };
        rows.push(format!("&\\text{{{}{colon}}}", latex::words(&line.words)));
    }
    if let Some((first, rest)) = line.equal.split_first() {
        let rest: Vec<String> = rest.iter().map(formula_as_latex).collect();
        rows.push(format!("{} &= {}", formula_as_latex(first), rest.join(" = ")));
    }
    rows
}

fn formula_as_latex(formula: &DerivationFormula) -> String {
    match formula {
        DerivationFormula::Expression(expression) => latex::expression(expression),
        DerivationFormula::Waves { series, phase } => terms::sum(terms::waves(
            series,
            |coefficient| latex::expression(&Expr::from(coefficient)),
            &latex::NOTATION,
            *phase,
        )),
        DerivationFormula::Linear(terms) => {
            terms::sum(terms.iter().map(|DerivativeTerm { factor, of, derivatives }| {
                match derivatives {
                    0 => latex::expression(&(factor * &Expr::from(*of))),
                    _ => format!("{}{}{}", before(factor), symbol(*of), "'".repeat(*derivatives)),
                }
            }))
        }
        DerivationFormula::AtZero { of, derivatives } => {
            format!("{}{}(0)", symbol(*of), "'".repeat(*derivatives))
        }
        DerivationFormula::Integral { factor, from, to, integrand, variable } => {
            let inside = match integrand.as_ref() {
                DerivationFormula::Expression(sum) if sum.terms().len() > 1 => {
                    format!("\\left({}\\right)", latex::inside(sum))
                }
                other => formula_as_latex(other),
            };
            format!(
                "{}\\int_{{{}}}^{{{}}} {inside} \\, \\mathrm{{d}}{}",
                before(factor),
                latex::expression(from),
                latex::expression(to),
                symbol(*variable)
            )
        }
        DerivationFormula::OverRoot(numerator, inside) => format!(
            "\\frac{{{}}}{{\\sqrt{{{}}}}}",
            latex::expression(numerator),
            match inside.as_ref() {
                DerivationFormula::Expression(inside) => latex::inside(inside),
                inside => formula_as_latex(inside),
            }
        ),
        DerivationFormula::Slope { factor, of, by } => format!(
            "{}\\frac{{\\mathrm{{d}}{}}}{{\\mathrm{{d}}{}}}",
            before(factor),
            symbol(*of),
            symbol(*by)
        ),
    }
}

/// A factor in front of something that is not an expression.
fn before(factor: &Expr) -> String {
    match (*factor == Expr::one(), factor.terms().len() > 1) {
        (true, _) => String::new(),
        (_, true) => format!("\\left({}\\right) ", latex::inside(factor)),
        _ => format!("{} ", latex::expression(factor)),
    }
}

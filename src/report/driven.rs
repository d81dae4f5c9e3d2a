//! A driven motion: its slow equations, its steady motions in symbols, and at numbers compared with
//! the true ones.

use std::borrow::Cow;

use super::{Block, Document, size_in_percent};
use crate::decimal::{decimal, significant};
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::exact::Polynomial;
use crate::expr::Expr;
use crate::solution::{Modulation, Response, Solution};
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FIRST_HARMONIC, FREQUENCY};
use crate::values::Values;
use crate::verify::{JudgedState, Verdict, Verification};

/// The document of a driven motion.
pub(super) fn driven<'a>(
    solution: &'a Solution,
    response: &Response,
    verification: Option<&Verification>,
) -> Document<'a> {
    let title = Block::Title {
        words: solution.title(),
        amplitude: solution.amplitude.in_words(solution.coordinate()),
    };
    let mut sections = vec![vec![Block::Question(&solution.equation)], vec![title]];
    match &solution.modulation {
        Some(slow) => {
            sections.push(slow_equations(solution, response, slow));
            sections.push(steady_motions(solution, response));
        }
        None => sections.push(motion_in_time(solution, response)),
    }
    let notes = solution.validity.iter().map(|note| Block::Note(note.to_string()));
    let heading = Block::Heading("Validity".to_owned());
    sections.push(std::iter::once(heading).chain(notes).collect());
    if let Some(verification) = verification {
        sections.push(match solution.in_time() {
            Some(_) => judged_in_time(verification),
            None => judged(verification, solution),
        });
    }
    Document { sections }
}

fn equation<'a>(
    left: impl Into<DerivationFormula>,
    right: impl Into<DerivationFormula>,
) -> Block<'a> {
    Block::Line(Cow::Owned(DerivationLine::equation(left, right)))
}

/// An equation with words before it.
fn equation_with_words<'a>(
    words: &str,
    left: impl Into<DerivationFormula>,
    right: impl Into<DerivationFormula>,
) -> Block<'a> {
    Block::Line(Cow::Owned(DerivationLine::equation(left, right).because(words)))
}

/// The motion as a function of time.
fn motion_in_time<'a>(solution: &'a Solution, response: &Response) -> Vec<Block<'a>> {
    let heading = match solution.equilibrium.is_zero() {
        true => format!("Released at rest from {} = {AMPLITUDE}", solution.coordinate()),
        false => format!("Released at rest at the distance {AMPLITUDE} from the equilibrium"),
    };
    let mut blocks =
        vec![Block::Heading(heading), equation(solution.coordinate(), response.motion.clone())];
    blocks.extend(solution.definitions.iter().map(Block::Definition));
    blocks
}

/// The motion in amplitude and phase, and their rates.
pub(super) fn slow_equations<'a>(
    solution: &'a Solution,
    response: &Response,
    slow: &Modulation,
) -> Vec<Block<'a>> {
    let mut blocks = vec![
        Block::Heading("Motion and slow equations".to_owned()),
        equation(solution.coordinate(), response.motion.clone()),
        equation(slow.amplitude.derivative(), slow.amplitude_rate.clone()),
        equation(slow.phase.derivative(), slow.phase_rate.clone()),
    ];
    blocks.extend(solution.definitions.iter().map(Block::Definition));
    blocks
}

fn steady_motions<'a>(solution: &'a Solution, response: &Response) -> Vec<Block<'a>> {
    let mut blocks = vec![Block::Heading("Steady motions".to_owned())];
    let detuning = detuning(solution);
    let polynomial = |polynomial: &Polynomial| Expr::from(polynomial);
    let squares = response.branches.as_ref().zip(detuning).and_then(|(branches, detuning)| {
        branches.by_squares(detuning, solution.amplitude.symbol())
    });
    match (&response.relation, squares) {
        (_, Some([left, right])) => {
            blocks.push(equation_with_words("frequency response", left, right))
        }
        (Some(relation), None) => {
            blocks.push(equation_with_words(
                "frequency response",
                Expr::zero(),
                polynomial(relation),
            ));
        }
        (None, None) => {}
    }
    if let (Some(branches), Some(detuning)) = (&response.branches, detuning) {
        let centre = polynomial(&branches.centre);
        if let Ok(width) = polynomial(&branches.width_squared).sqrt() {
            let either = [&centre - &width, &centre + &width];
            let words = ["solved for the detuning", "and"];
            for (words, branch) in words.iter().zip(either) {
                blocks.push(equation_with_words(words, detuning, branch));
            }
        }
    }
    if let Some(closed) = &response.closed {
        blocks.push(equation_with_words(
            "frequency response",
            Expr::zero(),
            closed.relation.clone(),
        ));
        if let (Some(detuning), Ok(width)) = (detuning, closed.width_squared.sqrt()) {
            blocks.push(equation_with_words(
                "solved for the detuning",
                detuning,
                &closed.centre - &width,
            ));
            blocks.push(equation_with_words("and", detuning, &closed.centre + &width));
        }
    }
    if let Some(frequency) = solution.law.frequency() {
        blocks.push(equation_with_words("backbone", Symbol::new("omega"), polynomial(frequency)));
    }
    if let Some(form) = solution.law.closed_form() {
        blocks.push(equation_with_words("backbone", Symbol::new("omega"), form.value.clone()));
    }
    let a = solution.amplitude.symbol();
    if let Some(peak) = &response.peak {
        blocks.push(equation_with_words("largest amplitude", a, peak.clone()));
    }
    for fold in &response.folds {
        let square = Expr::product([Expr::from(a), Expr::from(a)]);
        blocks.push(equation_with_words("branches meet at", square, fold.clone()));
    }
    if let Some(jumps) = &response.jumps {
        blocks.push(equation_with_words(
            "jumps, where this discriminant changes its sign",
            Expr::zero(),
            polynomial(jumps),
        ));
    }
    blocks
}

fn detuning(solution: &Solution) -> Option<Symbol> {
    let resonance = solution.modulation.as_ref()?.resonance.as_ref()?;
    Some(resonance.detuning.symbol)
}

/// Values in running text: ` at A = 1, eps = 2`.
pub(super) fn values_in_words(at: &Values) -> String {
    let at = at.iter();
    let at: Vec<String> = at.map(|(name, value)| format!("{name} = {value}")).collect();
    if at.is_empty() { String::new() } else { format!(" at {}", at.join(", ")) }
}

fn judged_in_time<'a>(verification: &Verification) -> Vec<Block<'a>> {
    let at = values_in_words(&verification.at);
    let mut blocks = vec![Block::Heading(format!("Judged against the true motion{at}"))];
    blocks.extend(verification.ranges.iter().map(|range| Block::Note(range.text.clone())));
    let percent = |part: Option<f64>| part.map_or("without a number".to_owned(), size_in_percent);
    blocks.push(Block::Note(format!(
        "largest deviation {} of the largest displacement, residual {} of the force (rms)",
        percent(verification.max_deviation),
        percent(verification.residual)
    )));
    blocks.push(Block::Note(format!(
        "verdict {}: |largest deviation| <= {} %",
        verification.verdict.name(),
        significant(100.0 * verification.tolerance, 3)
    )));
    blocks
}

fn judged<'a>(verification: &Verification, solution: &Solution) -> Vec<Block<'a>> {
    let at = values_in_words(&verification.at);
    let mut blocks = vec![Block::Heading(format!("Steady motions{at}, beside the true ones"))];
    if verification.steady_states.is_empty() {
        blocks.push(Block::Note(
            "none: to this order the slow equations have no steady motion at these values"
                .to_owned(),
        ));
    } else {
        let a = FIRST_HARMONIC.written();
        // The names of a table must have the lifetime of the program.
        let kept = |name: String| Symbol::new(&name).name();
        blocks.push(Block::table(
            [
                (a, kept(format!("${a}$"))),
                ("phase", "phase"),
                ("stable", "stable"),
                (kept(format!("true {a}")), kept(format!("true ${a}$"))),
                ("error", "error"),
                ("deviation", "deviation"),
                ("true stable", "true stable"),
            ],
            verification.steady_states.iter().map(row),
        ));
    }
    let stable = verification.steady_states.iter().filter(|judged| judged.state.is_stable());
    let count = stable.count();
    let verdict = verification.verdict.name();
    let tolerance = verification.tolerance;
    let within = significant(100.0 * tolerance, 3);
    blocks.push(Block::Note(format!(
        "{} steady motions, {count} stable; {FREQUENCY} = {} of the motion itself",
        verification.steady_states.len(),
        verification.frequency.map_or_else(String::new, decimal)
    )));
    blocks.extend(left_out(verification.spurious).map(Block::Note));
    blocks.extend(quality(verification).map(Block::Note));
    if count == 0 {
        blocks.push(Block::Note(format!(
            "verdict {verdict}: no steady motion is stable, so that there is none to be seen"
        )));
        return blocks;
    }
    let far_off = verification.max_deviation.filter(|deviation| *deviation > tolerance);
    let motion = match (verification.verdict, far_off) {
        (Verdict::Pass, Some(deviation)) => {
            format!("; its motion is off by {} %", significant(100.0 * deviation, 3))
        }
        _ => String::new(),
    };
    blocks.push(Block::Note(format!(
        "verdict {verdict}: of the largest stable one |error of {}| <= {within} %, and the true one is stable too{motion}",
        solution.amplitude.symbol()
    )));
    blocks
}

/// A remark on spurious steady motions, which only the truncation has; `None` if there are none.
fn left_out(count: usize) -> Option<String> {
    let motions = match count {
        0 => return None,
        1 => "1 more steady motion".to_owned(),
        count => format!("{count} more steady motions"),
    };
    Some(format!(
        "{motions} of the truncated slow equations left out: at such an amplitude the last order is more than half of the one before it, so that the series hardly converges, and no true motion is near"
    ))
}

/// The quality of the formula of the judged motion: its residual in the equation, and the order of
/// its error.
fn quality(verification: &Verification) -> Option<String> {
    let residual = verification.residual?;
    let slope = match verification.slope {
        Some(slope) => format!("vanishes with the power {slope:.2} of all that is small"),
        None => "could not be measured for smaller values".to_owned(),
    };
    let residual = significant(100.0 * residual, 3);
    Some(format!(
        "residual of the judged motion {residual} % of the force (rms); its deviation {slope}"
    ))
}

fn row(judged: &JudgedState) -> Vec<String> {
    let yes = |stable: bool| if stable { "yes" } else { "no" }.to_owned();
    let part = |part: Option<f64>| {
        part.map_or_else(String::new, |part| format!("{} %", significant(100.0 * part, 3)))
    };
    vec![
        decimal(judged.state.amplitude),
        decimal(judged.state.phase),
        yes(judged.state.is_stable()),
        judged.true_amplitude.map_or_else(|| "none found".to_owned(), decimal),
        part(judged.relative_error),
        part(judged.max_deviation),
        judged.true_stable.map_or_else(String::new, yes),
    ]
}

//! Documents as text that reads like a textbook. Formulas print so that they can be typed back in.
//!
//! In come a result or its document of [`report`], and a width; out goes plain text in lines no
//! longer than that, where words allow it. Relative errors are in percent.

pub(super) mod comparison;
mod impact;
mod lines;
mod table;

pub use super::steps::text as steps;
use crate::decimal::{decimal, significant};
use crate::derivation::NOTATION;
use crate::exact::Polynomial;
pub use crate::report::percent;
use crate::report::{self, Block, Document, size_in_percent};
use crate::series::terms;
use crate::solution::{Method, Solution, Sum, constant_in_words};
use crate::symbol::Symbol;
use crate::symbol::letters::{FREQUENCY, of_frequency};
use crate::verify::comparison::Comparison;
use crate::verify::{Followed, Verification};
pub use lines::fitted;

/// The derived formula, and its verification if there is one.
///
/// ```
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// let text = lindstedt::export::text::solution(&solution, None);
/// assert!(text.contains(&solution.formula()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solution(solution: &Solution, verification: Option<&Verification>) -> String {
    let _letters = solution.letters().in_force();
    document(&report::solution(solution, verification), usize::MAX)
}

/// Every method in one table, and below it those that do not apply, in lines of at most `width`
/// characters where words allow it. Formulas are at the end of their rows if all of them fit there,
/// and otherwise below the table.
///
/// ```
/// use lindstedt::{Oscillator, verify::comparison::compare};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let table = compare(&pendulum, &"A = 1".parse()?, None, 0.01)?;
/// let text = lindstedt::export::text::comparison(&table, 80);
/// assert!(text.contains("Lindstedt-Poincare"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn comparison(comparison: &Comparison, width: usize) -> String {
    let _letters = comparison.letters().in_force();
    document(&report::comparison(comparison), width)
}

/// A document as text, in lines of at most `width` characters where its blocks can be broken and
/// words allow it.
///
/// ```
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// let document = lindstedt::report::solution(&solution, None);
/// assert!(lindstedt::export::text::document(&document, 80).contains(&solution.formula()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn document(document: &Document, width: usize) -> String {
    let page = TextLayout { width, longest_title: comparison::longest_title(document) };
    let sections = document.sections.iter();
    let sections: Vec<String> = sections
        .map(|blocks| blocks.iter().map(|block| page.fitted(block, blocks)).collect())
        .collect();
    sections.join("\n")
}

/// The common layout of the blocks of a document.
struct TextLayout {
    width: usize,
    /// The longest name of a method, beside which words stand.
    longest_title: usize,
}

impl TextLayout {
    /// The lines of a block, none longer than the page where they can be broken; `section` is where
    /// it stands.
    fn fitted(&self, block: &Block, section: &[Block]) -> String {
        let text = self.block(block, section);
        match block {
            // Tables adapt to the width themselves.
            Block::Table { .. } | Block::Methods { .. } => text,
            _ => fitted(&text, self.width),
        }
    }

    /// The lines of a block without breaks; `section` is where it stands.
    fn block(&self, block: &Block, section: &[Block]) -> String {
        match block {
            Block::Question(equation) => format!("{equation}\n"),
            Block::QuestionAsTyped(equation) => format!("{equation}\n"),
            Block::Title { words, amplitude } => format!("{words}, {amplitude}\n"),
            Block::Heading(words) => format!("{words}\n"),
            Block::Note(words) | Block::Remark(words) | Block::Detail(words) => {
                format!("  {words}\n")
            }
            Block::Sentence(words) => comparison::wrapped(words, self.width, "  ", "  ") + "\n",
            Block::Table { head, rows } => table::table(head, rows, self.width),
            Block::Law { left, right } => format!("  {:<8}= {right}\n", left.to_string()),
            Block::Equality { left, right } => format!("  {left} = {right}\n"),
            Block::Line(line) => format!("  {line}\n"),
            Block::CycleAmplitude { symbol, amplitude } => {
                format!("  limit cycle of amplitude {symbol} = {amplitude}\n")
            }
            Block::Motion(solution) => motion(solution),
            Block::Harmonics { coordinate, series, amplitude, rounded, phase } => {
                let law = |coefficient: &Polynomial| {
                    Sum::new(coefficient, *rounded, |term| term.exponent(*amplitude)).to_string()
                };
                let waves = terms::waves(series, law, &NOTATION, *phase);
                let waves = if waves.is_empty() { vec!["0".to_owned()] } else { waves };
                let first = format!("  {coordinate}(t) = ");
                terms::lines(&waves, &first, "         ").join("\n") + "\n"
            }
            Block::Definition(definition) => {
                format!("  {} = {}\n", definition.symbol, definition.meaning_in_words())
            }
            Block::Value { name, value, source } => {
                let width =
                    section.iter().filter_map(name_of_value).map(|name| name.written().len()).max();
                let source = source.map_or(String::new(), |source| format!("   ({source})"));
                let width = width.unwrap_or(0);
                format!("  {:<width$} = {}{source}\n", name.written(), decimal(*value))
            }
            Block::Judged { verification, series_of_omega, hbar } => {
                judged(verification, *series_of_omega, *hbar)
            }
            Block::Truth { equation, at, frequency } => comparison::truth(equation, at, frequency),
            Block::Methods { rows, tolerance, .. } => comparison::methods(rows, *tolerance, self),
            Block::Entries { heading, entries } => comparison::entries(heading, entries, self),
            Block::Facts(facts) => facts_in_lines(facts),
            Block::Refused(refused) => comparison::refused(refused, self),
            Block::TrueMotion(lines) => comparison::true_motion(lines, self.width),
            Block::Closing(words) => comparison::wrapped(words, self.width, "", "") + "\n",
            Block::Reading { words, .. } => format!("{words}\n"),
            Block::Fitted { fitted, barrier, rule, letters, per_stiffness } => {
                impact::fitted(fitted, *barrier, *rule, *letters, *per_stiffness)
            }
            Block::Phase { phase, letters, release } => impact::phase(phase, *letters, release),
            Block::ClosedForms(pieces) => super::simulation::phase_lines(pieces),
            Block::Quantities { columns, rows, deviations, shapes } => {
                impact::quantities(columns, rows, deviations, shapes)
            }
            Block::ContactLaws { rows } => impact::contact_laws(rows),
            Block::ImpactMethods { rows, truth, tolerance } => {
                impact::methods(rows, *truth, *tolerance, self.width)
            }
            Block::SiValue { name, formula, value, unit, words } => {
                impact::si_value(name, *formula, *value, unit, words)
            }
            Block::SiQuantities { columns, rows } => impact::si_quantities(columns, rows),
            Block::Verdicts { verdicts, tolerance } => impact::verdicts(verdicts, *tolerance),
        }
    }
}

fn name_of_value(block: &Block) -> Option<Symbol> {
    match block {
        Block::Value { name, .. } => Some(*name),
        _ => None,
    }
}

/// Quantities and their numbers, one a line.
fn facts_in_lines(facts: &[(&str, String)]) -> String {
    let width = facts.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let line = |(name, value): &(&str, String)| format!("  {name:<width$}  {value}\n");
    facts.iter().map(line).collect()
}

/// The reason why an answer has no motion.
pub(super) fn without_motion(solution: &Solution) -> &'static str {
    match solution.method {
        // The motion of this method is a formula, so that it was not requested.
        Method::LindstedtPoincare => "the motion is left out",
        _ => "the motion follows by quadrature of the energy",
    }
}

/// The motion, one harmonic a line.
fn motion(solution: &Solution) -> String {
    if let Some(motion) = &solution.closed_motion {
        return format!("  {}(t) = {motion}\n", solution.coordinate());
    }
    if solution.displacement.is_zero() {
        return format!("  {}\n", without_motion(solution));
    }
    let waves = terms::waves(
        &solution.displacement,
        |coefficient| solution.ordered(coefficient).to_string(),
        &NOTATION,
        solution.phase(),
    );
    let first = format!("  {}(t) = ", solution.coordinate());
    let mut lines = terms::lines(&waves, &first, "         ");
    lines.push(format!("         {} = {}\n", solution.phase(), angle(solution)));
    lines.join("\n")
}

/// The phase of a motion.
fn angle(solution: &Solution) -> String {
    let Some(slow) = solution.slow() else {
        return format!("{FREQUENCY}*t");
    };
    let phase = slow.phase;
    let Some(resonance) = &slow.resonance else {
        return phase.to_string();
    };
    let driven = match resonance.times_driving {
        1 => format!("{}*t", resonance.driving_frequency),
        times => format!("{times}*{}*t", resonance.driving_frequency),
    };
    match resonance.times_linear {
        1 => format!("{driven} - {phase}"),
        times => format!("({driven} - {phase})/{times}"),
    }
}

/// The comparison of a motion that is not periodic, line by line.
fn followed(followed: &Followed) -> Vec<(&'static str, String)> {
    let mut lines =
        vec![("followed to", format!("t = {}: {}", decimal(followed.until), followed.reason))];
    if let Some(error) = followed.amplitude_error {
        let error = size_in_percent(error);
        lines.push(("error of amplitude", format!("{error} of that at the start")));
    }
    let time = |time: Option<f64>| time.map_or("not seen".to_owned(), decimal);
    if followed.tenth.or(followed.true_tenth).is_some() {
        let [formula, truth] = [followed.tenth, followed.true_tenth].map(time);
        lines.push(("a tenth is left at", format!("t = {formula}; true t = {truth}")));
        if let Some(action) = followed.tenth_by_action {
            lines.push(("by the action at", format!("t = {}", decimal(action))));
        }
    }
    lines
}

/// The verdict, number by number.
fn judged(verification: &Verification, series_of_omega: Option<f64>, hbar: Symbol) -> String {
    let (heading, facts) = judgement(verification, series_of_omega, hbar);
    let line = |(name, value): (String, String)| format!("  {name:<20}{value}\n");
    facts.into_iter().fold(heading + "\n", |text, fact| text + &line(fact))
}

/// The conditions and the numbers of a verification.
pub(super) fn judgement(
    verification: &Verification,
    series_of_omega: Option<f64>,
    hbar: Symbol,
) -> (String, Vec<(String, String)>) {
    /// Relative error of the frequency that counts as large: at any order, one halving of the small
    /// parameter does not take such an error into rounding.
    const LARGE: f64 = 1e-5;
    let at = verification.at.iter();
    let at: Vec<String> =
        at.map(|(name, value)| format!("{name} = {}", constant_in_words(value))).collect();
    let heading = match at.is_empty() {
        true => "Judged against the true motion".to_owned(),
        false => format!("Judged against the true motion at {}", at.join(", ")),
    };
    let mut facts = Vec::new();
    let mut line = |name: &str, value: String| facts.push((name.to_owned(), value));
    let reason = || verification.reason.as_ref().map(ToString::to_string).unwrap_or_default();
    line(FREQUENCY.written(), verification.frequency.map_or_else(reason, decimal));
    line(&format!("true {FREQUENCY}"), decimal(verification.true_frequency));
    if let Some(error) = verification.relative_error {
        line("relative error", percent(error));
    }
    let judged_on = match series_of_omega {
        Some(other) if other.is_finite() => format!(
            "the root of {FREQUENCY}^2; the series of {FREQUENCY} itself errs by {}",
            percent(other)
        ),
        Some(_) => {
            format!("the root of {FREQUENCY}^2; the series of {FREQUENCY} itself has no value")
        }
        None => of_frequency(verification.judged_on),
    };
    line("judged on", judged_on);
    if let Some(deviation) = verification.max_deviation {
        let deviation = size_in_percent(deviation);
        line(
            "largest deviation",
            match verification.followed {
                None => format!("{deviation} of the amplitude over one period"),
                Some(_) => format!("{deviation} of the amplitude at the start"),
            },
        );
    }
    if let Some(reason) = &verification.no_deviation {
        line("largest deviation", format!("not judged: {reason}"));
    }
    for (name, value) in verification.followed.iter().flat_map(followed) {
        line(name, value);
    }
    if let Some(residual) = verification.residual {
        line("residual", format!("{} of the force (rms)", size_in_percent(residual)));
    }
    // An error that is large now does not vanish in rounding when the small parameter is halved.
    let large = verification.relative_error.is_some_and(|error| error.abs() > LARGE);
    let unknown = match (verification.over_several_wells, large) {
        (true, _) => "not measured: motions over both wells do not become small",
        (false, true) => "not measured",
        (false, false) => "hidden by rounding",
    };
    let slope =
        |slope: Option<f64>| slope.map_or(unknown.to_owned(), |slope| format!("{slope:.2}"));
    let slope = match &verification.followed {
        None => slope(verification.slope),
        Some(followed) => match (verification.slope, followed.amplitude_slope) {
            (None, None) => "not measured".to_owned(),
            (deviation, amplitude) => format!(
                "{} of the deviation, {} of the amplitude, over times of 1/small",
                slope(deviation),
                slope(amplitude)
            ),
        },
    };
    line("slope of the error", slope);
    for (name, value) in &verification.chosen {
        let how = if *name == hbar { " (least squared residual)" } else { "" };
        line(name.written(), format!("{}{how}", significant(*value, 6)));
    }
    for range in &verification.ranges {
        let mark = if range.outside { "  <- outside" } else { "" };
        line("range", format!("{}{mark}", range.text));
    }
    line("verdict", verification.verdict_in_words());
    (heading, facts)
}

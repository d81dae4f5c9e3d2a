//! Nonlinear normal modes of coupled equations: frequency laws, motions, modal lines, verdicts.

use std::borrow::Cow;

use num_traits::Zero;

use super::{Block, Document, in_powers_of, percent, size_in_percent};
use crate::decimal::{decimal, significant};
use crate::derivation::DerivationLine;
use crate::exact::{Polynomial, Polynomials};
use crate::expr::Expr;
use crate::modes::{ModeBalance, NonlinearMode, NormalModes};
use crate::series::FourierSeries;
use crate::solution::Sum;
use crate::symbol::letters::FREQUENCY;
use crate::symbol::{Symbol, fresh, phase_beside};
use crate::verify::JudgedMode;

/// Nonlinear normal modes to be reported.
#[derive(Clone, Copy, Debug)]
pub struct ModesReport<'a> {
    /// The modes.
    pub modes: &'a NormalModes,
    /// The verdict on each mode that has a formula, or the reason why there is none; empty without
    /// values.
    pub judged: &'a [Result<JudgedMode, String>],
    /// The largest error of a passing mode.
    pub tolerance: f64,
}

impl<'a> ModesReport<'a> {
    /// The modes that have a formula, each with what it was judged to be.
    pub(crate) fn judged_modes(
        &self,
    ) -> impl Iterator<Item = (&'a NonlinearMode, Option<&'a Result<JudgedMode, String>>)> {
        let judged = self.judged.iter().map(Some).chain(std::iter::repeat(None));
        self.modes.modes.iter().flatten().zip(judged)
    }

    /// The name of the phase of a motion.
    pub(crate) fn phase(&self) -> Symbol {
        let equations = &self.modes.system.equations;
        let names = equations.coordinates.iter().chain(&equations.parameters);
        phase_beside(&names.copied().collect::<Vec<_>>())
    }
}

/// The document of nonlinear normal modes.
///
/// ```
/// use lindstedt::modes::{FreeSystem, ModeOptions, derive};
/// use lindstedt::report::{ModesReport, modes};
///
/// let pair = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0")?;
/// let found = derive(&pair, &ModeOptions::default())?;
/// let report = ModesReport { modes: &found, judged: &[], tolerance: 0.01 };
/// let text = lindstedt::export::text::document(&modes(&report), 100);
/// assert!(text.contains("omega^2 = 1 + 3*a^2/16 - 101*a^4/2048"), "{text}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn modes<'a>(report: &ModesReport<'a>) -> Document<'a> {
    let mut sections = head(report);
    let mut judged = report.judged.iter();
    for mode in &report.modes.modes {
        sections.push(match mode {
            Ok(mode) => one_mode(report, mode, judged.next()),
            Err(error) => {
                let help = error.help().map(|help| Block::Remark(format!("try: {help}")));
                std::iter::once(Block::Note(error.to_string())).chain(help).collect()
            }
        });
    }
    sections.push(validity(report.modes));
    Document { sections }
}

/// The equations and the formulas of modes, without verdicts.
pub(super) fn modes_in_formulas(modes: &NormalModes) -> Vec<Vec<Block<'_>>> {
    let report = ModesReport { modes, judged: &[], tolerance: 0.0 };
    let mut sections = head(&report);
    sections.extend(modes.modes.iter().flatten().map(|mode| one_mode(&report, mode, None)));
    sections
}

/// The equations, and the title.
fn head<'a>(report: &ModesReport<'a>) -> Vec<Vec<Block<'a>>> {
    let modes = report.modes;
    let equations = modes.system.equations.equations.iter();
    let mut question: Vec<Block> =
        equations.map(|(left, right)| equation(left.clone(), right.clone())).collect();
    let places = modes.system.equations.coordinates.iter().zip(&modes.system.rest);
    let moved = places.filter(|(_, place)| !place.is_zero());
    question.extend(moved.map(|(name, place)| {
        Block::Note(format!("{name} is counted from its place of rest, {place}"))
    }));
    let amplitude = modes.amplitude.symbol();
    let approximants = modes.modes.iter().flatten().find_map(|mode| mode.approximant.as_ref());
    let approximant = approximants.map_or(String::new(), |approximant| {
        format!(", omega^2 by its approximant {} in {amplitude}^2", approximant.degrees)
    });
    let method = match balance_of(modes) {
        Some(balance) => format!("balance of harmonics {}", balance.harmonics_in_words()),
        None => {
            format!("Lindstedt-Poincare to order {} in {amplitude}{approximant}", modes.order)
        }
    };
    let title = Block::Heading(format!(
        "Nonlinear normal modes by {method}; {} = {FREQUENCY}*t",
        report.phase()
    ));
    let mut sections = vec![question, vec![title]];
    sections.extend(balance_of(modes).map(|balance| written_balance(report, balance)));
    sections
}

/// The balance of harmonics, which all modes share but for their amplitudes.
fn balance_of(modes: &NormalModes) -> Option<&ModeBalance> {
    modes.modes.iter().flatten().find_map(|mode| mode.balance.as_ref())
}

/// The motion in the unknowns of a balance, and its equations.
fn written_balance<'a>(report: &ModesReport<'a>, balance: &'a ModeBalance) -> Vec<Block<'a>> {
    let mode = report.modes.modes.iter().flatten().next();
    let mut blocks: Vec<Block> = mode.map_or(vec![], |mode| motion(report, mode));
    match balance.equations.split_last() {
        None => blocks.push(Block::Note(
            "its equations are not written out: the forces are no polynomials, or they are too long to be read"
                .to_owned(),
        )),
        Some((_, equations)) => {
            let names: Vec<String> = balance.unknowns().iter().map(ToString::to_string).collect();
            blocks.push(Block::Detail(format!("for {}:", names.join(", "))));
            let equations = equations.iter();
            blocks.extend(equations.map(|right| Block::Equality { left: Expr::zero(), right }));
        }
    }
    blocks
}

fn equation<'a>(left: Expr, right: Expr) -> Block<'a> {
    Block::Line(Cow::Owned(DerivationLine::equation(left, right)))
}

/// A polynomial of a mode in one line.
fn in_line(mode: &NonlinearMode, polynomial: &Polynomial) -> String {
    mode.ordered(polynomial).to_string()
}

fn one_mode<'a>(
    report: &ModesReport<'a>,
    mode: &'a NonlinearMode,
    judged: Option<&'a Result<JudgedMode, String>>,
) -> Vec<Block<'a>> {
    let coordinates = &report.modes.system.equations.coordinates;
    let names: Vec<String> = coordinates.iter().map(ToString::to_string).collect();
    let shape: Vec<String> = mode.linear.shape.iter().map(|entry| in_line(mode, entry)).collect();
    let mut blocks = vec![
        Block::Title {
            words: format!("Mode {}", mode.number),
            amplitude: amplitude_in_words(mode, coordinates),
        },
        Block::Note(format!(
            "at small amplitudes {FREQUENCY}^2 = {}, {} = {}",
            in_line(mode, &mode.linear.square),
            names.join(" : "),
            shape.join(" : ")
        )),
    ];
    if !mode.derivation.is_empty() {
        blocks.push(Block::Note("derivation".to_owned()));
        blocks.extend(mode.derivation.iter().map(|line| Block::Line(Cow::Borrowed(line))));
    }
    if !mode.derivation.is_empty() {
        blocks.push(Block::Note("result".to_owned()));
    }
    let law = |left: Expr, right: Sum| Block::Law { left, right };
    let omega = Expr::from(FREQUENCY);
    let squared = &omega * &omega;
    match &mode.approximant {
        _ if mode.balance.is_some() => {}
        // A quotient of rounded numbers would be one of long whole numbers.
        Some(own) if mode.rounded => {
            let taken = report.modes.system.names();
            let names = ["p", "q"].map(|letter| fresh(letter, &taken));
            let [p, q] = names.map(Expr::from);
            let quotient = Expr::divide(&p, &q).unwrap_or_else(|_| p.clone());
            blocks.push(Block::Line(Cow::Owned(DerivationLine::equation(squared, quotient))));
            let parts = [(p, &own.above), (q, &own.below)];
            blocks.extend(parts.map(|(name, part)| law(name, mode.ordered(part))));
        }
        Some(own) => blocks.push(Block::Equality { left: squared, right: &own.value }),
        None => blocks.push(law(squared, mode.ordered(&mode.frequency_squared))),
    }
    match mode.balance.as_ref().map(|balance| balance.equations.last()) {
        None => blocks.extend(motion(report, mode)),
        Some(amplitude) => {
            blocks.extend(amplitude.map(|right| Block::Equality { left: Expr::zero(), right }))
        }
    }
    let others = coordinates.iter().zip(&mode.lines).enumerate();
    let others = others.filter(|(index, _)| *index != mode.along);
    blocks.extend(others.map(|(_, (name, line))| law(Expr::from(*name), mode.ordered(line))));
    blocks.extend(mode.definitions.iter().map(Block::Definition));
    let near = match (mode.near.is_empty(), judged) {
        (true, Some(Ok(judged))) => &judged.near,
        _ => &mode.near,
    };
    blocks.extend(near.iter().map(|near| {
        let times = if near.ratio == 1 { String::new() } else { format!("{}*", near.ratio) };
        Block::Note(format!(
            "near internal resonance: the frequency of mode {} is within {} % of {times}{FREQUENCY}; a divisor is small, and the formula is good for \
             small {} alone",
            near.other,
            significant(50.0 * near.distance.abs(), 2),
            mode.amplitude.symbol()
        ))
    }));
    blocks.extend(judged.map(|judged| match judged {
        Ok(judged) => Block::Facts(facts(report, mode, judged)),
        Err(reason) => Block::Note(reason.clone()),
    }));
    let coefficients = judged.iter().flat_map(|judged| judged.as_ref().ok());
    let coefficients = coefficients.flat_map(|judged| &judged.coefficients);
    blocks.extend(coefficients.map(|&(name, value)| Block::Value { name, value, source: None }));
    blocks
}

/// The harmonics of every coordinate.
fn motion<'a>(report: &ModesReport<'a>, mode: &'a NonlinearMode) -> Vec<Block<'a>> {
    let coordinates = report.modes.system.equations.coordinates.iter().zip(&mode.motion);
    let harmonics =
        |(coordinate, series): (&Symbol, &'a FourierSeries<Polynomials>)| Block::Harmonics {
            coordinate: *coordinate,
            series,
            amplitude: mode.amplitude.symbol(),
            rounded: mode.rounded,
            phase: report.phase(),
        };
    coordinates.map(harmonics).collect()
}

/// The definition of the amplitude of a mode.
fn amplitude_in_words(mode: &NonlinearMode, coordinates: &[Symbol]) -> String {
    use crate::solution::AmplitudeConvention::{FirstHarmonic, Initial};
    let symbol = mode.amplitude.symbol();
    match mode.amplitude {
        Initial => {
            let name = coordinates[mode.along];
            format!("{symbol} = {name}(0), and every velocity is zero at t = 0")
        }
        FirstHarmonic => {
            let terms = mode.linear.modal.iter().zip(coordinates);
            let terms = terms.filter(|(factor, _)| !factor.is_zero());
            let terms = terms.map(|(factor, name)| match mode.rounded {
                true => in_line(mode, &factor.product(&Polynomial::symbol(*name))),
                false => (Expr::from(factor) * Expr::from(*name)).to_string(),
            });
            let sum = crate::series::terms::sum(terms);
            format!("{symbol} = amplitude of the first harmonic of {sum}")
        }
    }
}

fn facts(
    report: &ModesReport,
    mode: &NonlinearMode,
    judged: &JudgedMode,
) -> Vec<(&'static str, String)> {
    let within = significant(100.0 * judged.tolerance, 3);
    let number = |value: Option<f64>| value.map_or("not real".to_owned(), decimal);
    let mut facts =
        vec![("omega", number(judged.frequency)), ("true omega", decimal(judged.true_frequency))];
    // The formula has letters where the equations have.
    if !(judged.law.is_empty() || report.modes.system.equations.parameters.is_empty()) {
        let law = in_powers_of(mode.amplitude.symbol().written(), &judged.law);
        facts.insert(0, ("omega^2 in numbers", law));
    }
    facts.extend(judged.relative_error.map(|error| ("relative error", percent(error))));
    facts.push((
        "largest deviation",
        format!(
            "{} of the largest displacement over a period",
            size_in_percent(judged.max_deviation)
        ),
    ));
    facts.extend(judged.slope.map(|slope| ("slope of the error", format!("{slope:.2}"))));
    facts.push(("verdict", format!("{} (|relative error| <= {within} %)", judged.verdict.name())));
    facts
}

fn validity(modes: &NormalModes) -> Vec<Block<'static>> {
    let amplitude = modes.amplitude.symbol();
    let mut notes = vec![
        Block::Heading("Validity".to_owned()),
        Block::Note(match balance_of(modes) {
            Some(balance) => format!(
                "harmonics {} balanced, those above left out; solved by numbers at an amplitude, from the linear mode on",
                balance.harmonics_in_words()
            ),
            None => format!(
                "truncated after {amplitude}^{}; an expansion for small {amplitude}",
                modes.order
            ),
        }),
    ];
    let stopped = modes.modes.iter().flatten().filter(|mode| mode.order < modes.order);
    notes.extend(stopped.map(|mode| {
        Block::Note(format!(
            "stopped early: mode {} is truncated after {amplitude}^{}",
            mode.number, mode.order
        ))
    }));
    notes.extend(notes_on_rounding(modes));
    notes
}

/// A note on rounded coefficients, where there are any.
pub(super) fn notes_on_rounding(modes: &NormalModes) -> Vec<Block<'static>> {
    let rounded = modes.modes.iter().flatten().any(|mode| mode.rounded);
    let note = "numbers with a point are rounded: the linear frequency is no fraction";
    if rounded { vec![Block::Note(note.to_owned())] } else { vec![] }
}

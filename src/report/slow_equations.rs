//! Slow equations of several coordinates: rates, motion, steady motions, verdicts.

use std::borrow::Cow;

use super::certificate::percent;
use super::driven::values_in_words;
use super::{Block, Document, Heading, in_powers_of, size_in_percent};
use crate::decimal::{decimal, significant};
use crate::derivation::DerivationLine;
use crate::expr::{Expr, ExprError};
use crate::multiple_scales::SlowMotion;
use crate::symbol::{Symbol, fresh};
use crate::verify::{JudgedSlowMotion, JudgedSteadyMotion};

/// Slow equations to be reported.
#[derive(Clone, Copy, Debug)]
pub struct SlowReport<'a> {
    /// The slow equations.
    pub slow: &'a SlowMotion,
    /// Their steady motions, or their motion, at values beside the true ones; `None` without values.
    pub judged: Option<&'a JudgedSlowMotion>,
}

/// The document of slow equations.
///
/// # Errors
/// A step of algebra that fails.
///
/// ```
/// use lindstedt::multiple_scales::{CoupledSystem, MultipleScalesOptions, derive};
/// use lindstedt::report::{SlowReport, slow_equations};
///
/// let system = CoupledSystem::parse("x'' + x - x*y = 0; y'' + w2^2*y - x^2 = 0")?;
/// let resonance = Some("w2 = 2*omega1".to_owned());
/// let slow = derive(&system, &MultipleScalesOptions { resonance, ..Default::default() })?;
/// let report = SlowReport { slow: &slow, judged: None };
/// let text = lindstedt::export::text::document(&slow_equations(&report)?, 100);
/// assert!(text.contains("a1' = -a1*a2*sin(gamma1)/4"), "{text}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn slow_equations<'a>(report: &SlowReport<'a>) -> Result<Document<'a>, ExprError> {
    let slow = report.slow;
    let equations = slow.system.equations.equations.iter();
    let mut question: Vec<Block> =
        equations.map(|(left, right)| line(left.clone(), right.clone())).collect();
    let places = slow.system.equations.coordinates.iter().zip(&slow.system.rest);
    let moved = places.filter(|(_, place)| !place.is_zero());
    question.extend(moved.map(|(name, place)| {
        Block::Note(format!("{name} is counted from its place of rest, {place}"))
    }));
    let mut sections = vec![question, vec![title(slow)]];
    sections.push(linear_modes(slow));
    if !slow.derivation.is_empty() {
        let lines = slow.derivation.iter().map(|line| Block::Line(Cow::Borrowed(line)));
        sections
            .push(std::iter::once(Block::Heading("Derivation".to_owned())).chain(lines).collect());
    }
    let mut rates = vec![Block::Heading("Motion and slow equations".to_owned())];
    for (name, motion) in slow.system.equations.coordinates.iter().zip(&slow.motion) {
        rates.push(line(Expr::from(*name), motion.clone()));
    }
    rates.extend(self::rates(slow)?);
    sections.push(rates);
    sections.extend(constants(slow)?);
    sections.extend(relations(slow));
    sections.extend(report.judged.map(|judged| beside_true_motions(slow, judged)));
    sections.push(validity(slow));
    Ok(Document { sections })
}

/// The rates of amplitudes and phases, and what they name.
pub(super) fn rates(slow: &SlowMotion) -> Result<Vec<Block<'static>>, ExprError> {
    let mut blocks = Vec::new();
    for mode in 0..slow.rates.len() {
        let [amplitude, phase] = slow.rate(mode)?;
        blocks.push(line(Expr::from(slow.amplitudes[mode].derivative()), amplitude));
        blocks.push(line(Expr::from(slow.phases[mode].derivative()), phase));
    }
    for (index, (name, _)) in slow.slow_phases.iter().enumerate() {
        blocks.extend(slow.meaning(index).map(|meaning| line(Expr::from(*name), meaning)));
    }
    let definitions = slow.detunings.iter().chain(&slow.definitions);
    blocks.extend(definitions.map(|known| line(Expr::from(known.symbol), known.meaning.clone())));
    Ok(blocks)
}

fn line<'a>(left: Expr, right: Expr) -> Block<'a> {
    Block::Line(Cow::Owned(DerivationLine::equation(left, right)))
}

/// Names in a row.
fn listed<T: ToString>(names: impl IntoIterator<Item = T>) -> String {
    names.into_iter().map(|name| name.to_string()).collect::<Vec<_>>().join(", ")
}

fn title<'a>(slow: &SlowMotion) -> Block<'a> {
    Block::Title {
        words: format!("{} in {}", slow.title(), small(slow)),
        amplitude: format!(
            "{} = amplitudes of the first harmonics of the modes",
            listed(&slow.amplitudes)
        ),
    }
}

/// The small parameter, in words.
fn small(slow: &SlowMotion) -> String {
    slow.system.small.map_or_else(|| "the amplitudes".to_owned(), |name| name.to_string())
}

fn linear_modes<'a>(slow: &SlowMotion) -> Vec<Block<'a>> {
    let mut blocks = Vec::new();
    let names: Vec<String> =
        slow.system.equations.coordinates.iter().map(ToString::to_string).collect();
    for (index, (frequency, shape)) in slow.frequencies.iter().zip(&slow.shapes).enumerate() {
        let alone = shape.iter().filter(|entry| !entry.is_zero()).count() == 1;
        let shape = match alone {
            true => {
                let moving = shape.iter().position(|entry| !entry.is_zero()).unwrap_or(0);
                format!("{} alone", names[moving])
            }
            false => format!(
                "{} = {}",
                names.join(" : "),
                shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(" : ")
            ),
        };
        blocks.push(Block::Note(format!(
            "mode {}: linear frequency {frequency}, {shape}",
            index + 1
        )));
    }
    blocks.push(Block::Note(match slow.resonances.as_slice() {
        [] => "no resonance between the frequencies".to_owned(),
        resonances => format!("near the resonance {}", resonances.join(", ")),
    }));
    blocks
}

/// What stays constant where nothing damps or drives the modes.
fn constants<'a>(slow: &SlowMotion) -> Result<Option<Vec<Block<'a>>>, ExprError> {
    let (Some(invariants), Some((phase, _))) = (slow.invariants(), slow.slow_phases.first()) else {
        return Ok(None);
    };
    let equations = &slow.system.equations;
    let taken = equations.parameters.iter().chain(&equations.coordinates).copied();
    let taken: Vec<Symbol> = taken.collect();
    let names = (1..).map(|number: usize| fresh(&format!("E{number}"), &taken));
    let all = names.zip(invariants.expressions(*phase)?);
    let heading = Block::Heading("Constants of the slow motion".to_owned());
    let lines = all.map(|(name, expression)| line(Expr::from(name), expression));
    Ok(Some(std::iter::once(heading).chain(lines).collect()))
}

/// The closed relations of steady motions, a section for each choice of modes at rest.
fn relations<'a>(slow: &SlowMotion) -> Vec<Vec<Block<'a>>> {
    let mut sections: Vec<Vec<Block>> = Vec::new();
    let mut last: Option<Vec<usize>> = None;
    for relation in slow.steady_relations() {
        if last.as_ref() != Some(&relation.at_rest) {
            sections.push(vec![Block::Title {
                words: "Steady motions, the phases eliminated".to_owned(),
                amplitude: match relation.at_rest.as_slice() {
                    [] => "every mode moving".to_owned(),
                    modes => {
                        format!("{} = 0", listed(modes.iter().map(|m| slow.amplitudes[*m])))
                    }
                },
            }]);
            last = Some(relation.at_rest.clone());
        }
        if let Some(section) = sections.last_mut() {
            section.push(match relation.solved {
                Some((name, square)) => line(Expr::from(name) * Expr::from(name), square),
                None => line(Expr::zero(), Expr::from(&relation.relation)),
            });
        }
    }
    sections
}

/// Steady motions, or a motion, at values beside the true ones.
fn beside_true_motions<'a>(slow: &SlowMotion, judged: &JudgedSlowMotion) -> Vec<Block<'a>> {
    let within = format!("{} %", percent(judged.tolerance));
    let verdict = judged
        .verdict
        .map(|verdict| ("verdict", format!("{} (error <= {within})", verdict.name())));
    let slope = judged.slope.map(|slope| {
        (
            "slope of the error",
            format!("{slope:.2}: the deviation falls with this power of all that is small"),
        )
    });
    if let Some(transient) = &judged.transient {
        let mut facts = vec![
            ("until", decimal(transient.until)),
            (
                "largest deviation",
                format!("{} of the largest displacement", size_in_percent(transient.error)),
            ),
        ];
        if let Some(exchange) = &transient.exchange {
            let ranges = slow.amplitudes.iter().zip(&exchange.amplitudes);
            let ranges: Vec<String> = ranges
                .map(|(name, [least, most])| {
                    format!("{name} from {} to {}", decimal(*least), decimal(*most))
                })
                .collect();
            facts.push(("exchange", ranges.join(", ")));
            let period = decimal(exchange.period);
            facts.push((
                "its period",
                match exchange.parameter {
                    0.0 => format!("{period}, trigonometric"),
                    m => {
                        format!("{period} = {}*K(m), m = {}", decimal(exchange.factor), decimal(m))
                    }
                },
            ));
            let squares = slow.amplitudes.iter().zip(&exchange.squares);
            let squares = squares
                .filter(|(_, [_, slope])| *slope != 0.0)
                .map(|(name, square)| format!("{name}^2 = {}", in_powers_of("s", square)));
            facts.push(("their squares", squares.collect::<Vec<_>>().join(", ")));
            let [low, high] = exchange.ends.map(decimal);
            facts.push((
                "with the variable s",
                format!(
                    "s'^2 = {}, from 0 on to and fro between {low} and {high}",
                    in_powers_of("s", &exchange.rate_squared)
                ),
            ));
        }
        facts.extend(slope);
        facts.extend(verdict);
        return vec![
            Block::Heading(format!(
                "Motion from the given amplitudes{}",
                values_in_words(&judged.at)
            )),
            Block::Facts(facts),
        ];
    }
    let mut blocks = vec![Block::Heading(format!("Steady motions{}", values_in_words(&judged.at)))];
    if judged.steady.is_empty() {
        blocks.push(Block::Note(
            "no steady motion was found that stands alone: others are members of families, as without damping or drive, or on the edge of stability; give amplitudes, such as a1=0.1, for a motion"
                .to_owned(),
        ));
        return blocks;
    }
    let names = slow.amplitudes.iter().chain(&slow.phases);
    let undriven = judged.steady.iter().any(|motion| motion.frequency.is_some());
    let frequencies = if undriven { &["omega", "true omega"][..] } else { &[] };
    let head: Vec<Heading> = names
        .map(|name| Heading::from(name.name()))
        .chain(frequencies.iter().copied().map(Heading::from))
        .chain(["stable", "true motion"].map(Heading::from))
        .collect();
    let rows = judged.steady.iter().map(|motion| {
        let numbers = motion.state.amplitudes.iter().chain(&motion.state.phases);
        let stable = match motion.state.growth {
            Some(growth) if growth < 0.0 => "yes",
            Some(growth) if growth > 0.0 => "no",
            _ => "neutral",
        };
        let both = match motion.frequency {
            Some((own, truth)) => [decimal(own), truth.map_or("-".to_owned(), decimal)],
            None => ["-".to_owned(), "-".to_owned()],
        };
        numbers
            .map(|number| decimal(*number))
            .chain(both.into_iter().filter(|_| undriven))
            .chain([stable.to_owned(), beside_truth(motion)])
            .collect::<Vec<String>>()
    });
    blocks.push(Block::Table { head, rows: rows.collect() });
    if judged.has_families {
        blocks.push(Block::Note(
            "other steady motions are members of families or on the edge of stability; they are not listed"
                .to_owned(),
        ));
    }
    let turning =
        judged.steady.iter().any(|motion| motion.state.turning.iter().any(|rate| *rate != 0.0));
    if turning {
        blocks.push(Block::Note(
            "phases that no drive fixes go on turning; those listed are of one moment".to_owned(),
        ));
    }
    let facts: Vec<_> = slope.into_iter().chain(verdict).collect();
    if !facts.is_empty() {
        blocks.push(Block::Facts(facts));
    }
    blocks
}

/// The true motion beside a steady one, in words.
fn beside_truth(motion: &JudgedSteadyMotion) -> String {
    match (motion.compared, motion.error) {
        (false, _) => "-".to_owned(),
        (true, None) => "not found near it".to_owned(),
        (true, Some(error)) => {
            let stable = match motion.truly_stable {
                Some(true) => ", stable",
                Some(false) => ", unstable",
                None => "",
            };
            format!("{} off{stable}", size_in_percent(error))
        }
    }
}

fn validity(slow: &SlowMotion) -> Vec<Block<'static>> {
    let mut notes = vec![Block::Heading("Validity".to_owned())];
    notes.push(Block::Note(match slow.system.small {
        Some(name) => format!(
            "truncated after {name}^{}; terms without {name} that have to be small, damping and detunings among them, count as its first power",
            slow.order
        ),
        None => format!(
            "truncated after order {}: a term of degree d counts d - 1; damping, detunings and drives at a resonance count {}",
            slow.order, slow.small_order
        ),
    }));
    if slow.averaging {
        notes.push(Block::Note(
            "means of the forces along the linear motion; --method multiple-scales has the harmonics of the motion and higher orders"
                .to_owned(),
        ));
    }
    if slow.leaves_out && !slow.averaging {
        notes.push(Block::Note(format!(
            "terms of the equations are of a higher order and left out: --order {} has the next ones",
            slow.order + 1
        )));
    }
    let acts = !slow.slow_phases.is_empty();
    if !slow.resonances.is_empty() && !acts {
        notes.push(Block::Note(format!(
            "to this order the resonance {} does not act: no phase stands in the slow equations",
            slow.resonances.join(", ")
        )));
    }
    for near in &slow.near {
        notes.push(Block::Note(format!(
            "a divisor is small: the wave of frequency {} is within {} % of that of mode {}, and no resonance says so",
            near.frequency,
            significant(100.0 * near.distance, 2),
            near.mode
        )));
    }
    if slow.rounded {
        notes.push(Block::Note(
            "coefficients are rounded to 15 digits: squares of linear frequencies are no fractions"
                .to_owned(),
        ));
    }
    notes
}

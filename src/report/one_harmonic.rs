//! Normal modes of two coordinates with one harmonic: families, branch points, verdicts.

use std::borrow::Cow;

use super::driven::values_in_words;
use super::{Block, Document, percent, size_in_percent};
use crate::decimal::decimal;
use crate::derivation::DerivationLine;
use crate::expr::Expr;
use crate::modes::{OneHarmonicFamily, OneHarmonicModes};
use crate::symbol::letters::{AMPLITUDE, FREQUENCY};
use crate::verify::JudgedOneHarmonic;

/// Modes with one harmonic to be reported.
#[derive(Clone, Copy, Debug)]
pub struct OneHarmonicReport<'a> {
    /// The modes.
    pub modes: &'a OneHarmonicModes,
    /// Those with an amplitude beside the true motions; `None` without values.
    pub judged: Option<&'a JudgedOneHarmonic>,
}

/// The document of modes with one harmonic.
///
/// ```
/// use lindstedt::modes::{FreeSystem, one_harmonic_modes};
/// use lindstedt::report::{OneHarmonicReport, one_harmonic};
///
/// let pair = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0")?;
/// let modes = one_harmonic_modes(&pair)?;
/// let report = OneHarmonicReport { modes: &modes, judged: None };
/// let text = lindstedt::export::text::document(&one_harmonic(&report), 100);
/// assert!(text.contains("r = 1/(2 - omega^2)"), "{text}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn one_harmonic<'a>(report: &OneHarmonicReport<'a>) -> Document<'a> {
    let modes = report.modes;
    let equations = modes.system.equations.equations.iter();
    let question: Vec<Block> =
        equations.map(|(left, right)| line(left.clone(), right.clone())).collect();
    let names = &modes.system.equations.coordinates;
    let (x, y) = (names[0], names.get(1).copied().unwrap_or(names[0]));
    let title = Block::Heading(format!(
        "Normal modes with one harmonic: {x} = {AMPLITUDE}*cos({FREQUENCY}*t), {y} = {}*{x}",
        modes.ratio
    ));
    let mut sections = vec![question, vec![title]];
    let square = |name: Expr| &name * &name;
    let (omega, amplitude) = (Expr::from(FREQUENCY), Expr::from(AMPLITUDE));
    for family in &modes.families {
        let (words, lines) = match family {
            OneHarmonicFamily::Similar { ratio, frequency_squared } => (
                "similar mode, the same ratio at every amplitude",
                vec![
                    line(Expr::from(modes.ratio), ratio.clone()),
                    line(square(omega.clone()), frequency_squared.clone()),
                ],
            ),
            OneHarmonicFamily::AlongRatio { amplitude_squared, frequency_squared } => (
                "family in which the ratio changes with the amplitude",
                vec![
                    line(square(amplitude.clone()), amplitude_squared.clone()),
                    line(square(omega.clone()), frequency_squared.clone()),
                ],
            ),
            OneHarmonicFamily::AlongFrequency { ratio, amplitude_squared } => (
                "both modes, along the frequency",
                vec![
                    line(Expr::from(modes.ratio), ratio.clone()),
                    line(square(amplitude.clone()), amplitude_squared.clone()),
                ],
            ),
        };
        let title =
            Block::Title { words: words.to_owned(), amplitude: format!("{AMPLITUDE} = {x}(0)") };
        sections.push(std::iter::once(title).chain(lines).collect());
    }
    if !modes.branch_points.is_empty() {
        let points = modes.branch_points.iter().map(|point| {
            let (left, right) = &point.at;
            Block::Note(format!(
                "off the mode with {} = {} another branches at {left} = {right}",
                modes.ratio, point.ratio
            ))
        });
        let heading = Block::Heading("Branch points".to_owned());
        sections.push(std::iter::once(heading).chain(points).collect());
    }
    if !modes.definitions.is_empty() {
        sections.push(modes.definitions.iter().map(Block::Definition).collect());
    }
    sections.extend(report.judged.map(beside_true_motions));
    sections.push(vec![
        Block::Heading("Validity".to_owned()),
        Block::Note(
            "the first harmonic of each equation vanishes; higher harmonics are left out at every amplitude, and modes in which the first coordinate rests"
                .to_owned(),
        ),
    ]);
    Document { sections }
}

fn line<'a>(left: Expr, right: Expr) -> Block<'a> {
    Block::Line(Cow::Owned(DerivationLine::equation(left, right)))
}

fn beside_true_motions<'a>(judged: &JudgedOneHarmonic) -> Vec<Block<'a>> {
    let heading = Block::Heading(format!("Modes{}", values_in_words(&judged.at)));
    if judged.motions.is_empty() {
        return vec![heading, Block::Note("none has this amplitude".to_owned())];
    }
    let number = |value: Option<f64>| value.map_or("not found".to_owned(), decimal);
    let rows = judged.motions.iter().map(|motion| {
        vec![
            decimal(motion.ratio),
            decimal(motion.frequency),
            number(motion.true_frequency),
            motion.relative_error.map_or("-".to_owned(), percent),
        ]
    });
    let within = size_in_percent(judged.tolerance);
    vec![
        heading,
        Block::table(["ratio", "omega", "true omega", "relative error"], rows),
        Block::Facts(vec![(
            "verdict",
            format!("{} (|relative error| <= {within})", judged.verdict.name()),
        )]),
    ]
}

//! The formulas of an absorber: equations, relations, designs, verdicts.

use std::borrow::Cow;

use super::driven::values_in_words;
use super::{Block, Document, percent, size_in_percent};
use crate::absorber::{AbsorberKind, AbsorberLaws};
use crate::absorber_verdict::{AbsorberDecay, AbsorberTouch, JudgedAbsorber};
use crate::decimal::decimal;
use crate::derivation::DerivationLine;
use crate::expr::Expr;

/// The formulas of an absorber to be reported.
#[derive(Clone, Copy, Debug)]
pub struct AbsorberReport<'a> {
    /// The formulas.
    pub laws: &'a AbsorberLaws,
    /// The formulas in numbers beside the truth; `None` without values.
    pub judged: Option<&'a JudgedAbsorber>,
}

/// The document of an absorber.
///
/// ```
/// use lindstedt::absorber::{AbsorberKind, Excitation, derive};
/// use lindstedt::report::{AbsorberReport, absorber};
///
/// let laws = derive(AbsorberKind::Tuned(Excitation::Force))?;
/// let document = absorber(&AbsorberReport { laws: &laws, judged: None });
/// let text = lindstedt::export::text::document(&document, 100);
/// assert!(text.contains("f = 1/(1 + mu)"), "{text}");
/// # Ok::<(), lindstedt::absorber::AbsorberError>(())
/// ```
pub fn absorber<'a>(report: &AbsorberReport<'a>) -> Document<'a> {
    let laws = report.laws;
    let equations = laws.equations.iter();
    let question = equations.map(|(left, right)| line(left.clone(), right.clone())).collect();
    let meanings = laws.meanings.iter().map(|(name, words)| (name.name(), (*words).to_owned()));
    let relations = laws.relations.iter().map(|relation| {
        let line = DerivationLine::equation(relation.left.clone(), relation.right.clone());
        Block::Line(Cow::Owned(line.because(relation.words)))
    });
    let mut sections = vec![question, vec![Block::Facts(meanings.collect())], relations.collect()];
    if !laws.definitions.is_empty() {
        sections.push(laws.definitions.iter().map(Block::Definition).collect());
    }
    for design in &laws.designs {
        let title = Block::Title {
            words: capitalised(&design.name.replace('-', " ")),
            amplitude: design.words.to_owned(),
        };
        let formulas =
            design.formulas.iter().map(|own| line(Expr::from(own.symbol), own.formula.clone()));
        sections.push(std::iter::once(title).chain(formulas).collect());
    }
    let is_sink = matches!(
        laws.kind,
        AbsorberKind::ImpactSink | AbsorberKind::PendulumSink | AbsorberKind::CubicSink
    );
    sections.extend(report.judged.map(|judged| beside_the_truth(judged, is_sink)));
    sections
        .push(vec![Block::Heading("Validity".to_owned()), Block::Note(laws.validity.to_owned())]);
    Document { sections }
}

fn line<'a>(left: Expr, right: Expr) -> Block<'a> {
    Block::Line(Cow::Owned(DerivationLine::equation(left, right)))
}

fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn beside_the_truth<'a>(judged: &JudgedAbsorber, is_sink: bool) -> Vec<Block<'a>> {
    let number = |value: Option<f64>, none: &str| value.map_or(none.to_owned(), decimal);
    let rows = judged.formulas.iter().map(|own| {
        vec![
            own.design.replace('-', " "),
            own.symbol.to_string(),
            number(own.value, "none"),
            number(own.truth, if own.value.is_some() { "not found" } else { "none found" }),
            own.relative_error.map_or("-".to_owned(), percent),
        ]
    });
    let searched = judged.lowest_peak.iter().flat_map(|peak| {
        [("f", peak.tuning), ("zeta", peak.damping), ("h", peak.height)].map(|(symbol, value)| {
            let [design, symbol, none] = ["lowest peak", symbol, "-"].map(str::to_owned);
            vec![design, symbol, none.clone(), decimal(value), none]
        })
    });
    let rows = rows.chain(searched);
    let mut blocks = vec![
        Block::Heading(format!("Beside the truth{}", values_in_words(&judged.at))),
        Block::table(["design", "quantity", "formula", "truth", "relative error"], rows),
    ];
    if judged.lowest_peak.is_some() {
        blocks.push(Block::Note(
            "lowest peak: the highest amplitude at any frequency is the least (H-infinity), by a search; no formula is given"
                .to_owned(),
        ));
    }
    if let Some(AbsorberTouch { amplitude, sink }) = judged.touch {
        blocks.push(Block::Note(format!(
            "the motion with two impacts a period ends at C = {}, Z = {}, where a wall is touched between them; it is stable up to there",
            decimal(amplitude),
            decimal(sink)
        )));
    }
    if judged.motion.is_none() && is_sink {
        blocks
            .push(Block::Note("both masses set free on the manifold leave it at once".to_owned()));
    }
    if let Some(motion) = &judged.motion {
        blocks.push(Block::Note(format!(
            "{}: C from {} to {}, never farther from it than {} of the start",
            motion.words,
            decimal(motion.start),
            decimal(motion.end),
            size_in_percent(motion.largest_distance)
        )));
        if let Some(AbsorberDecay { amplitudes: [first, last], formula, truth }) = motion.decay {
            blocks.push(Block::Note(format!(
                "in that motion C falls from {} to {} in a time of {}, by the formula of t in {} ({}); its error falls with mu",
                decimal(first),
                decimal(last),
                decimal(truth),
                decimal(formula),
                percent(formula / truth - 1.0)
            )));
        }
    }
    let within = size_in_percent(judged.tolerance);
    // The time of a decay is to first order in the mass ratio, and is shown with its error alone.
    let what = match judged.motion.as_ref().and_then(|motion| motion.decay) {
        Some(_) => "|relative error| of the amplitudes in the table",
        None => "|relative error|",
    };
    blocks.push(Block::Facts(vec![(
        "verdict",
        match judged.verdict {
            Some(verdict) => format!("{} ({what} <= {within})", verdict.name()),
            None => "not judged: some truth was not found".to_owned(),
        },
    )]));
    blocks
}

//! The proved enclosures of an impact, and the errors of its closed forms that follow from them.

use super::certificate::{enclosed, percent, rounded_percent};
use super::{Block, Document};
use crate::certificate::{Enclosure, ImpactEnclosure, PowerLaw, SizeBounds};
use crate::decimal::{exact_decimal, not_above_typed};
use crate::exact::Rational;
use crate::impact::contact::Dashpot;
use crate::impact::{Impact, PhaseReading};
use crate::verify::Verdict;

/// An impact and its proved enclosures.
#[derive(Clone, Debug)]
pub struct ImpactCertificateReport<'a> {
    /// The impact with its closed forms.
    pub impact: &'a Impact,
    /// The enclosures.
    pub enclosure: &'a ImpactEnclosure,
    /// A and xc as exact numbers.
    pub exact: [&'a Rational; 2],
    /// The power laws whose sum is the force of the barrier.
    pub force: &'a [PowerLaw],
    /// lambda of a contact that loses energy.
    pub damping: Option<&'a Rational>,
    /// The largest relative error of a passing closed form.
    pub tolerance: f64,
}

impl ImpactCertificateReport<'_> {
    /// The proved numbers with their names: five, and two more of a contact that loses energy.
    pub fn proved(&self) -> Vec<(&'static str, &Enclosure)> {
        let losses = self.enclosure.losses();
        self.enclosure.in_order().into_iter().chain(losses.into_iter().flatten()).collect()
    }

    /// The names of the numbers, and the relative errors of Runge-Kutta and of each closed form
    /// from both sides.
    pub fn errors(&self) -> Vec<(&'static str, Vec<SizeBounds>)> {
        let proved = self.proved();
        let losses = self.impact.losses().map(|(judged, _)| judged);
        let quantities = self.impact.quantities().into_iter().chain(losses.into_iter().flatten());
        let quantities = quantities.zip(proved);
        let errors = quantities.map(|(quantity, (name, truth))| {
            let values = std::iter::once(&quantity.runge_kutta).chain(&quantity.closed_forms);
            (name, values.map(|value| truth.relative_error(*value)).collect())
        });
        errors.collect()
    }

    /// The verdict on every closed form: whether each of its numbers is proved to be within the
    /// tolerance.
    pub fn verdicts(&self) -> Vec<(PhaseReading, Verdict)> {
        let errors = self.errors();
        let within = |column: usize| {
            let mut ranges = errors.iter().filter_map(|(_, ranges)| ranges.get(column + 1));
            ranges.all(|range| range.upper <= not_above_typed(self.tolerance))
        };
        let columns = self.impact.columns.iter().enumerate();
        columns
            .map(|(index, column)| (column.reading, Verdict::from_passed(within(index))))
            .collect()
    }
}

/// The document of a proved impact.
pub fn impact_certificate<'a>(report: &ImpactCertificateReport<'a>) -> Document<'a> {
    // Exact values, as decimals if these are finite.
    let exactly = |value: &Rational| exact_decimal(value).unwrap_or_else(|| value.to_string());
    let [amplitude, barrier] = report.exact.map(exactly);
    let mut given = vec![
        ("A, released from rest at x = -A", amplitude),
        ("xc, the place of the barrier", barrier),
    ];
    match report.force {
        [law] if *law == PowerLaw::hertz(law.stiffness.clone()) => {
            given.push(("gamma, its stiffness", exactly(&law.stiffness)));
        }
        [law] => given.extend([
            ("stiffness of the barrier", exactly(&law.stiffness)),
            ("exponent of the depth", exactly(&law.exponent)),
        ]),
        laws => {
            let power = |law: &PowerLaw| {
                let factor = match exactly(&law.stiffness).as_str() {
                    "1" => String::new(),
                    stiffness => format!("{stiffness} "),
                };
                match exactly(&law.exponent).as_str() {
                    "1" => format!("{factor}d"),
                    exponent => format!("{factor}d^{exponent}"),
                }
            };
            let sum: Vec<String> = laws.iter().map(power).collect();
            given.push(("force of the barrier at the depth d", sum.join(" + ")));
        }
    }
    if let Some(damping) = report.damping {
        let dashpot = report.impact.setup.loss.and_then(|loss| loss.law.dashpot());
        let words = match dashpot {
            None => "lambda, its damping: the force is times 1 + lambda d'",
            Some(Dashpot::Pulls) => "lambda, its damping: the force is stiffness (d + lambda d')",
            Some(Dashpot::DoesNotPull) => {
                "lambda, its damping: the force is stiffness max(d + lambda d', 0)"
            }
        };
        given.push((words, exactly(damping)));
    }
    let proved = report.proved().into_iter();
    let proved = proved.map(|(name, enclosure)| (name, enclosed(enclosure))).collect();
    let within = percent(report.tolerance);
    let errors = report.errors();
    let verdict = |(index, (reading, verdict)): (usize, &(PhaseReading, Verdict))| {
        let column = || {
            let column = errors
                .iter()
                .filter_map(move |(name, ranges)| Some((*name, ranges.get(index + 1)?)));
            column.filter(|(_, range)| range.upper > not_above_typed(report.tolerance))
        };
        let names: Vec<&str> = column().map(|(name, _)| name).collect();
        let words = match (verdict, column().all(|(_, range)| range.lower > report.tolerance)) {
            (Verdict::Pass, _) => format!("pass (every number within {within} %, proved)"),
            (Verdict::Fail, true) => {
                format!("fail (beyond {within} %, proved: {})", names.join(", "))
            }
            (Verdict::Fail, false) => {
                format!("fail (not proved to be within {within} %: {})", names.join(", "))
            }
        };
        (reading.name(), words)
    };
    let head = ["", "Runge-Kutta"]
        .into_iter()
        .chain(report.impact.columns.iter().map(|column| column.reading.name()));
    let row = |(name, ranges): &(&'static str, Vec<SizeBounds>)| {
        let cells = ranges.iter().copied().map(rounded_percent);
        std::iter::once((*name).to_owned()).chain(cells).collect()
    };
    let verdicts = report.verdicts();
    Document {
        sections: vec![
            vec![Block::QuestionAsTyped(&report.impact.equation)],
            vec![
                Block::Heading("The impact, its numbers exact as they stand here".to_owned()),
                Block::Facts(given),
            ],
            vec![
                Block::Heading("Proved".to_owned()),
                Block::Facts(proved),
                Block::Note(match report.damping {
                    None => "times in units of 1/omega, angles in rad".to_owned(),
                    Some(_) => "times in units of 1/omega, angles in rad; the period ends where the motion turns after the impact".to_owned(),
                }),
            ],
            vec![
                Block::Heading(
                    "How far the numbers of Runge-Kutta and of each closed form are off, proved"
                        .to_owned(),
                ),
                Block::table(head, errors.iter().map(row)),
                Block::Note(
                    "a single number is rounded: both of its ends have these digits".to_owned(),
                ),
            ],
            vec![
                Block::Heading("Verdict".to_owned()),
                Block::Facts(verdicts.iter().enumerate().map(verdict).collect()),
            ],
        ],
    }
}

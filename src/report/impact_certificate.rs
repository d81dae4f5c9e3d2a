//! What is proved of an impact, and with it of its closed forms.

use super::certificate::{between, enclosed};
use super::{Block, Document, Heading};
use crate::certificate::{ImpactEnclosure, Range};
use crate::decimal::{plain_decimal, significant};
use crate::exact::Rational;
use crate::impact::{Impact, Reading};
use crate::verify::Verdict;

/// An impact and what is proved of it.
#[derive(Clone, Debug)]
pub struct ImpactCertificateReport<'a> {
    /// The impact with its closed forms.
    pub impact: &'a Impact,
    /// What is proved.
    pub enclosure: &'a ImpactEnclosure,
    /// A, xc and gamma as they were taken.
    pub exact: [&'a Rational; 3],
    /// The relative error up to which a closed form passes.
    pub tolerance: f64,
}

impl ImpactCertificateReport<'_> {
    /// The names of the numbers, and the relative errors of Runge-Kutta and of each closed form from both sides.
    fn errors(&self) -> Vec<(&'static str, Vec<Range>)> {
        let proved = self.enclosure.in_order();
        let quantities = self.impact.quantities().into_iter().zip(proved);
        let errors = quantities.map(|(quantity, (name, truth))| {
            let values = std::iter::once(&quantity.runge_kutta).chain(&quantity.closed_forms);
            (name, values.map(|value| truth.relative_error(*value)).collect())
        });
        errors.collect()
    }

    /// Of every closed form whether each of its numbers is proved to be within the tolerance.
    pub fn verdicts(&self) -> Vec<(Reading, Verdict)> {
        let errors = self.errors();
        let within = |column: usize| {
            let mut ranges = errors.iter().filter_map(|(_, ranges)| ranges.get(column + 1));
            ranges.all(|range| range.upper <= self.tolerance)
        };
        let columns = self.impact.columns.iter().enumerate();
        columns
            .map(|(index, column)| (column.reading, Verdict::of(within(index))))
            .collect()
    }
}

/// A fraction as it is: in decimals where they end.
fn exactly(value: &Rational) -> String {
    const MOST: usize = 40;
    let ten = Rational::from_integer(10.into());
    let mut scaled = value.clone();
    for places in 0..MOST {
        if scaled.is_integer() {
            return plain_decimal(value, places);
        }
        scaled *= &ten;
    }
    value.to_string()
}

/// The document of a proved impact.
pub fn impact_certificate<'a>(report: &ImpactCertificateReport<'a>) -> Document<'a> {
    let percent = |range: &Range| {
        let percent = Range {
            lower: 100.0 * range.lower,
            upper: 100.0 * range.upper,
        };
        between(percent, " %")
    };
    let [amplitude, barrier, stiffness] = report.exact.map(exactly);
    let given = vec![
        ("A, released from rest at x = -A", amplitude),
        ("xc, the place of the barrier", barrier),
        ("gamma, its stiffness", stiffness),
    ];
    let proved = report.enclosure.in_order();
    let proved = proved.map(|(name, enclosure)| (name, enclosed(enclosure)));
    let within = significant(100.0 * report.tolerance, 3);
    let errors = report.errors();
    let verdict = |(index, (reading, verdict)): (usize, &(Reading, Verdict))| {
        let column = || {
            let column = errors
                .iter()
                .filter_map(move |(name, ranges)| Some((*name, ranges.get(index + 1)?)));
            column.filter(|(_, range)| range.upper > report.tolerance)
        };
        let names: Vec<&str> = column().map(|(name, _)| name).collect();
        let words = match (verdict, column().all(|(_, range)| range.lower > report.tolerance)) {
            (Verdict::Pass, _) => format!("pass (every number within {within} %, proved)"),
            (Verdict::Fail, true) => format!("fail (beyond {within} %, proved: {})", names.join(", ")),
            (Verdict::Fail, false) => format!("fail (not proved to be within {within} %: {})", names.join(", ")),
        };
        (reading.name(), words)
    };
    let head = ["", "Runge-Kutta"]
        .into_iter()
        .chain(report.impact.columns.iter().map(|column| column.reading.name()));
    let row = |(name, ranges): &(&'static str, Vec<Range>)| {
        let cells = ranges.iter().map(percent);
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
                Block::Facts(proved.into()),
                Block::Note("times in units of 1/omega, angles in rad".to_owned()),
            ],
            vec![
                Block::Heading("How far the numbers of Runge-Kutta and of each closed form are off, proved".to_owned()),
                Block::Table {
                    head: head.map(|text| Heading { text, latex: text }).collect(),
                    rows: errors.iter().map(row).collect(),
                },
            ],
            vec![
                Block::Heading("Verdict".to_owned()),
                Block::Facts(verdicts.iter().enumerate().map(verdict).collect()),
            ],
        ],
    }
}

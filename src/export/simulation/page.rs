//! A simulation, or a sweep, as a page: the words and numbers of the text, with the impacts and the
//! states as tables and the phases of a chain as formulas.

use super::{Report, SweepReport, chain, content, notes};
use crate::export::html::{self, HtmlPage};
use crate::export::latex::{LatexTable, scientific_text};
use crate::impact::Integrator;
use crate::report::{Block, Document, Heading};

/// The page of a single run.
///
/// ```
/// use lindstedt::export::{html::HtmlPage, simulation::{Report, html}};
/// use lindstedt::impact::{Case, Integrator, Settings, simulate};
///
/// let (model, start) = Case { zeta: 0.05, ..Case::default() }.motion()?;
/// let motion = simulate(&model, start, Integrator::Chain, &Settings::default())?;
/// let report = Report { motion: &motion, judge: None, sources: ["given", "given"], tolerance: 1e-10, samples: &[], baseline: None, dissipation: None, units: None, known_until: None };
/// assert!(html(&report, &HtmlPage::default()).contains("<th><math"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulation(report: &Report, page: &HtmlPage) -> String {
    let equation = content::equation(&report.motion.model);
    html::document(&document(report, &equation), page)
}

/// The document of a single run.
fn document<'a>(report: &Report, equation: &'a str) -> Document<'a> {
    let motion = report.motion;
    let mut question = vec![Block::QuestionAsTyped(equation)];
    if content::is_mirrored(&motion.model) {
        question.push(Block::Sentence(content::MIRRORED.to_owned()));
    }
    question.push(Block::Facts(content::given(report)));
    let mut sections = vec![question];
    let damping = report.dissipation.and_then(|dissipation| content::damping(report, dissipation));
    if let Some((heading, entries)) = damping {
        sections.push(vec![Block::Heading(heading), Block::Facts(together(entries))]);
    }
    sections.push(impacts(report));
    if motion.integrator == Integrator::Chain {
        sections.push(phases(report));
    }
    let rest = content::rest(report);
    let mut section = vec![Block::Heading(rest.heading), Block::Facts(rest.times)];
    section.extend(rest.sentences.into_iter().map(Block::Sentence));
    sections.push(section);
    let energy = content::energy(motion);
    if !energy.is_empty() {
        let entry = |(name, value, words)| (name, format!("{value}{words}"));
        let energy = energy.into_iter().map(entry).collect();
        sections.push(vec![Block::Heading(content::ENERGY.to_owned()), Block::Facts(energy)]);
    }
    if !report.samples.is_empty() {
        let states = table(&content::STATE, content::states(report));
        sections.push(vec![Block::Heading(content::STATES.to_owned()), states]);
    }
    let paragraphs = [Some(content::end(motion).to_vec()), content::beside(report).map(Vec::from)];
    for paragraph in paragraphs.into_iter().flatten() {
        let mut lines = paragraph.into_iter();
        let mut section: Vec<Block> = lines.next().map(Block::Heading).into_iter().collect();
        section.extend(lines.map(Block::Sentence));
        sections.push(section);
    }
    let notes = notes(report).into_iter().map(|note| Block::Sentence(format!("note: {note}")));
    sections.push(notes.collect());
    Document { sections }
}

/// Entries, those without a name behind the one before.
fn together(entries: Vec<(&'static str, String)>) -> Vec<(&'static str, String)> {
    let mut named: Vec<(&str, String)> = Vec::new();
    for (name, words) in entries {
        match named.last_mut() {
            Some((_, before)) if name.is_empty() => {
                before.push_str("; ");
                before.push_str(&words);
            }
            _ => named.push((name, words)),
        }
    }
    named
}

/// A table; rows may be shorter than its head.
fn table<'a>(head: &[&'static str], rows: Vec<Vec<String>>) -> Block<'a> {
    let filled = |mut row: Vec<String>| {
        row.resize(head.len(), String::new());
        row
    };
    Block::Table {
        head: head.iter().map(|name| Heading::from(*name)).collect(),
        rows: rows.into_iter().map(filled).collect(),
    }
}

fn impacts<'a>(report: &Report) -> Vec<Block<'a>> {
    let impacts = content::impacts(report);
    let mut blocks = vec![Block::Heading(impacts.heading)];
    if !impacts.rows.is_empty() {
        let rows = impacts.rows.into_iter().chain(impacts.last).collect();
        blocks.push(table(&impacts.head, rows));
    }
    blocks.extend(impacts.more.map(Block::Remark));
    blocks
}

fn phases<'a>(report: &Report) -> Vec<Block<'a>> {
    let count = chain::phases(report.motion).len();
    let (pieces, more) = chain::listed(report.motion);
    let mut blocks = vec![
        Block::Heading(format!("Phases: {count}")),
        Block::Sentence(chain::MEANING.to_owned()),
        Block::ClosedForms(pieces),
    ];
    blocks.extend(more.map(Block::Remark));
    blocks
}

/// The page of a sweep, a row of its table for each motion.
pub fn sweep(report: &SweepReport, page: &HtmlPage) -> String {
    let number = |cell: String| match cell.parse::<f64>() {
        Ok(_) => format!("${}$", scientific_text(&cell)),
        Err(_) => cell,
    };
    let all_complete = report.rows.iter().all(|summary| summary.stop.is_complete());
    let row = |(row, summary)| {
        let cells = content::sweep_row(report, row, summary).into_iter().map(number);
        let warning = if summary.stop.is_complete() { "" } else { "incomplete" };
        cells.chain((!all_complete).then(|| warning.to_owned())).collect()
    };
    let mut head = content::sweep_head(report);
    head.extend((!all_complete).then(String::new));
    let table = LatexTable {
        places: "r".repeat(head.len()),
        head,
        rows: report.rows.iter().enumerate().map(row).collect(),
        framed: false,
    };
    html::table(&table, page)
}

//! An audit: a table of verdicts, and the evidence for every verdict other than `reproduced`.

use super::{Block, Document};
use crate::audit::{
    ABSENT, Audit, ClaimAttempt, ClaimFinding, Computed, NotComputable, PrintedStatement, Verdict,
};
use crate::decimal::{decimal, significant};

/// The document of an audit.
///
/// ```
/// use lindstedt::audit::{Claims, audit};
///
/// let claims: Claims = "[[claim]]\nid = \"one\"\nquantity = \"value\"\nformula = \"1 + 1\"\nprinted = \"3\"".parse()?;
/// let audit = audit(claims);
/// let text = lindstedt::export::text::document(&lindstedt::report::audit(&audit), 120);
/// assert!(text.contains("inconsistent") && text.contains("computed 2"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn audit(audit: &Audit) -> Document<'_> {
    let mut sections = vec![summary(audit)];
    for verdict in Verdict::ALL {
        let found: Vec<&ClaimFinding> =
            audit.findings.iter().filter(|finding| finding.verdict == verdict).collect();
        if !found.is_empty() {
            sections.push(table(verdict, &found));
        }
    }
    for finding in &audit.findings {
        let plain = finding.verdict == Verdict::Reproduced
            && finding.claim.note.is_none()
            && finding.is_as_expected();
        if !plain {
            sections.push(finding_blocks(finding));
        }
    }
    Document { sections }
}

fn summary(audit: &Audit) -> Vec<Block<'_>> {
    let counts = Verdict::ALL.map(|verdict| format!("{} {}", audit.count(verdict), verdict.name()));
    let title = match audit.title.is_empty() {
        true => "Audit".to_owned(),
        false => audit.title.clone(),
    };
    let unexpected = audit.findings.iter().filter(|finding| !finding.is_as_expected()).count();
    let expected = match unexpected {
        0 => "every verdict is the expected one".to_owned(),
        1 => "one verdict is not the expected one".to_owned(),
        count => format!("{count} verdicts are not the expected ones"),
    };
    vec![
        Block::Heading(title),
        Block::Note(format!("{}: {}", claims(audit.findings.len()), counts.join(", "))),
        Block::Note(expected),
    ]
}

fn table<'a>(verdict: Verdict, findings: &[&ClaimFinding]) -> Vec<Block<'a>> {
    let name = verdict.name();
    let assumes = verdict == Verdict::UnderAssumption;
    let row = |finding: &&ClaimFinding| {
        let cells = [
            finding.claim.place.clone(),
            finding.claim.id.clone(),
            printed(finding),
            computed(finding),
        ];
        let assumption = assumes.then(|| finding.assumption());
        cells.into_iter().chain(assumption).collect()
    };
    let head = ["where", "claim", "printed", "computed"]
        .into_iter()
        .chain(assumes.then_some("assumption"));
    vec![Block::Note(format!("verdict: {name}")), Block::table(head, findings.iter().map(row))]
}

/// The printed text, in one line.
pub(crate) fn printed(finding: &ClaimFinding) -> String {
    let entries = &finding.claim.entries;
    match &entries[..] {
        [entry] => entry.printed.clone(),
        [entry, ..] if matches!(entry.stated, PrintedStatement::Trend(_)) => entry.printed.clone(),
        several => format!("{} entries", several.len()),
    }
}

/// The computed value, in one line; empty if there is none.
pub(crate) fn computed(finding: &ClaimFinding) -> String {
    let Some(shown) = finding.displayed_attempt() else {
        return String::new();
    };
    let trend = matches!(
        finding.claim.entries.first().map(|entry| &entry.stated),
        Some(PrintedStatement::Trend(_))
    );
    match &shown.computed[..] {
        [_] => entry(finding, shown, 0)
            .or_else(|| required_value_in_words(finding))
            .unwrap_or_default(),
        several if trend => {
            let each: Vec<String> =
                (0..several.len()).filter_map(|index| entry(finding, shown, index)).collect();
            each.join(", ")
        }
        several => {
            let count = shown.reproduced.iter().filter(|entry| **entry).count();
            format!("{count} of {}", several.len())
        }
    }
}

/// The value of an unknown that a claim requires but that lies outside of its range, in words.
fn required_value_in_words(finding: &ClaimFinding) -> Option<String> {
    let demand = finding.demand?;
    Some(format!("needs {} = {}", demand.unknown.name, significant(demand.value, 3)))
}

/// The computed value of an entry, with two digits more than are printed, in the unit of the
/// printed number; `None` if it cannot be computed.
pub(crate) fn entry(finding: &ClaimFinding, tried: &ClaimAttempt, index: usize) -> Option<String> {
    let alike = |number: f64| match finding.claim.entries.get(index).map(|entry| &entry.stated) {
        Some(PrintedStatement::Number(printed)) => printed.formatted_alike(number, 6),
        _ => decimal(number),
    };
    match tried.computed.get(index)? {
        Ok(Computed::Number(number)) => Some(alike(*number)),
        Ok(Computed::Exact(fraction)) => Some(fraction.to_string()),
        Ok(Computed::Absent) => Some(ABSENT.to_owned()),
        Ok(Computed::Formula(formula)) => Some(formula.to_string()),
        Ok(Computed::Conflicts(conflicts)) => Some(match conflicts.len() {
            0 => "no conflict".to_owned(),
            1 => "one conflict".to_owned(),
            count => format!("{count} conflicts"),
        }),
        Err(NotComputable::Missing(_) | NotComputable::Refused(_)) => None,
    }
}

/// A claim and the evidence for its verdict.
fn finding_blocks(finding: &ClaimFinding) -> Vec<Block<'_>> {
    let claim = &finding.claim;
    let place = if claim.place.is_empty() { &claim.id } else { &claim.place };
    let says = if claim.says.is_empty() { String::new() } else { format!(": {}", claim.says) };
    let mut blocks = vec![
        Block::Heading(place.clone()),
        Block::Sentence(format!("{}, {}{says}", claim.id, finding.verdict.name())),
    ];
    let assumption = finding.assumption();
    if !assumption.is_empty() {
        blocks.push(Block::Sentence(format!("assumption: {assumption}")));
    }
    blocks.extend(finding.evidence.iter().cloned().map(Block::Sentence));
    blocks.extend(claim.note.iter().cloned().map(Block::Sentence));
    if !finding.is_as_expected() {
        let expected = claim.expected.map_or("reproduced", Verdict::name);
        blocks.push(Block::Sentence(format!("expected: {expected}")));
    }
    blocks
}

/// The number of claims in words.
fn claims(count: usize) -> String {
    match count {
        1 => "1 claim".to_owned(),
        count => format!("{count} claims"),
    }
}

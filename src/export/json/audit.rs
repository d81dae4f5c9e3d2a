//! Kind `audit`: claims of a publication, computed again.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::texts;
use crate::audit::{Audit, ClaimAttempt, ClaimFinding, Computed, Verdict};
use crate::report::{audit_computed, audit_entry, audit_printed};

/// Claims of a publication, computed again, with a verdict each.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct AuditDocument {
    /// The kind of document.
    pub schema: String,
    /// The publication; empty where the file names none.
    pub title: String,
    /// How many claims have each verdict.
    pub counts: AuditCounts,
    /// Whether every verdict is the expected one: the exit code is 0 then, and 3 if not.
    pub passes: bool,
    /// The claims, in the order of the file.
    pub claims: Vec<AuditClaim>,
}

/// How many claims have each verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct AuditCounts {
    /// Reproduced to every printed digit.
    pub reproduced: usize,
    /// Reproduced by something that the publication does not say.
    pub reproduced_under_assumption: usize,
    /// Not to be computed, for want of what is not printed.
    pub not_reproducible: usize,
    /// Something else is computed.
    pub inconsistent: usize,
}

/// One claim.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct AuditClaim {
    /// Its name in the file.
    pub id: String,
    /// Where it is printed.
    pub place: String,
    /// What is claimed, in words.
    pub says: String,
    /// What is printed, in one line; empty where that is no text.
    pub printed: String,
    /// What is computed, in one line, with the assumption where there is one; empty where nothing
    /// is.
    pub computed: String,
    /// The verdict.
    #[cfg_attr(feature = "schema", schemars(schema_with = "verdicts"))]
    pub verdict: String,
    /// What is supposed where it is reproduced under an assumption; null where it is not.
    pub assumption: Option<String>,
    /// What is needed and not printed.
    pub missing: Vec<String>,
    /// Why the verdict is what it is, sentence by sentence.
    pub evidence: Vec<String>,
    /// The verdict that the file expects; null where it says nothing, and the claim is expected to
    /// be reproduced.
    pub expected: Option<String>,
    /// Whether the verdict is the expected one.
    pub as_expected: bool,
    /// What is printed, entry by entry, beside what is computed.
    pub entries: Vec<AuditEntry>,
    /// What was supposed in turn, the claim alone first.
    pub tried: Vec<AuditTried>,
    /// What the claim asks of a number that is not printed; null where none was solved for.
    pub unknown: Option<AuditUnknown>,
    /// What the file says beside it; null where it says nothing.
    pub note: Option<String>,
}

/// One thing that is printed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct AuditEntry {
    /// As it is printed.
    pub printed: String,
    /// What is computed, in words; null where nothing is.
    pub computed: Option<String>,
    /// The same as a number; null where it is none.
    pub value: Option<f64>,
    /// Whether it comes out as it is printed; of a trend, whether the whole of it does.
    pub reproduced: bool,
}

/// The claim under some suppositions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct AuditTried {
    /// What is supposed; empty for the claim alone.
    pub supposing: Vec<String>,
    /// How many entries come out.
    pub reproduced: usize,
    /// What is computed for each entry; null where it is no number.
    pub values: Vec<Option<f64>>,
}

/// What a claim asks of a number that is not printed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct AuditUnknown {
    /// Its name.
    pub name: String,
    /// A value that makes the claim come out.
    pub value: f64,
    /// The least and the greatest such value beside it.
    pub range: [f64; 2],
    /// Where it may lie.
    pub within: [f64; 2],
    /// Whether it does.
    pub is_within: bool,
}

/// The schema of the name of a verdict.
#[cfg(feature = "schema")]
fn verdicts(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
    schemars::json_schema!({ "type": "string", "enum": Verdict::ALL.map(Verdict::name) })
}

/// The document of an audit.
///
/// ```
/// use lindstedt::audit::{Claims, audit};
///
/// let claims: Claims = "[[claim]]\nid = \"one\"\nquantity = \"value\"\nformula = \"1 + 1\"\nprinted = \"2\"".parse()?;
/// let document = lindstedt::export::json::audit(&audit(claims));
/// assert_eq!((document.passes, document.claims[0].verdict.as_str()), (true, "reproduced"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn audit(audit: &Audit) -> AuditDocument {
    AuditDocument {
        schema: DocumentKind::Audit.schema().to_owned(),
        title: audit.title.clone(),
        counts: AuditCounts {
            reproduced: audit.count(Verdict::Reproduced),
            reproduced_under_assumption: audit.count(Verdict::UnderAssumption),
            not_reproducible: audit.count(Verdict::NotReproducible),
            inconsistent: audit.count(Verdict::Inconsistent),
        },
        passes: audit.passes(false),
        claims: audit.findings.iter().map(claim).collect(),
    }
}

fn number(found: &Result<Computed, crate::audit::NotComputable>) -> Option<f64> {
    found.as_ref().ok()?.number().filter(|number| number.is_finite())
}

fn claim(finding: &ClaimFinding) -> AuditClaim {
    let own = &finding.claim;
    let shown = finding.displayed_attempt();
    let entry = |(index, printed): (usize, &crate::audit::PrintedEntry)| AuditEntry {
        printed: printed.printed.clone(),
        computed: shown.and_then(|tried| audit_entry(finding, tried, index)),
        value: shown.and_then(|tried| number(tried.computed.get(index)?)),
        reproduced: shown
            .is_some_and(|tried| tried.reproduced.get(index).is_some_and(|entry| *entry)),
    };
    let tried = |tried: &ClaimAttempt| AuditTried {
        supposing: texts(&tried.supposing),
        reproduced: tried.reproduced.iter().filter(|entry| **entry).count(),
        values: tried.computed.iter().map(number).collect(),
    };
    let assumption = finding.assumption();
    AuditClaim {
        id: own.id.clone(),
        place: own.place.clone(),
        says: own.says.clone(),
        printed: audit_printed(finding),
        computed: audit_computed(finding),
        verdict: finding.verdict.name().to_owned(),
        assumption: (!assumption.is_empty()).then_some(assumption),
        missing: finding.missing.clone(),
        evidence: finding.evidence.clone(),
        expected: own.expected.map(|verdict| verdict.name().to_owned()),
        as_expected: finding.is_as_expected(),
        entries: own.entries.iter().enumerate().map(entry).collect(),
        tried: finding.tried.iter().map(tried).collect(),
        unknown: finding.demand.map(|demand| AuditUnknown {
            name: demand.unknown.name.name().to_owned(),
            value: demand.value,
            range: demand.range,
            within: demand.unknown.within,
            is_within: demand.is_within,
        }),
        note: own.note.clone(),
    }
}

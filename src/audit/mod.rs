//! Claims of a publication, each computed again: a verdict on every printed number, formula and
//! table.
//!
//! In: an [`Audit`]'s question, a list of [`Claim`]s, from a file by [`Claims`] or made in Rust.
//! Out: the [`Audit`], a [`ClaimFinding`] for each: `reproduced` to every printed digit;
//! `reproduced-under-assumption`, by the fewest of the suppositions that the claim allows, or by an
//! unknown number solved for; `not-reproducible`, because a needed quantity is not printed;
//! `inconsistent` with the computed value. Printed numbers serve only for comparison.
//!
//! ```
//! use lindstedt::audit::{Claims, Verdict, audit};
//!
//! let claims: Claims = r#"
//! [[claim]]
//! id = "phase"
//! where = "equation (16)"
//! says = "the phase of the return"
//! quantity = "value"
//! formula = "acos(xc/A)"
//! values = { A = 1.5, xc = 0.323 }
//! printed = "1.3537"
//! suppose = { rounding = ["cut"] }
//! "#.parse()?;
//! let audit = audit(claims);
//! assert_eq!(audit.findings[0].verdict, Verdict::UnderAssumption);
//! assert_eq!(audit.findings[0].assumption(), "digits cut off");
//! # Ok::<(), lindstedt::problem::ProblemError>(())
//! ```

mod claim;
#[cfg(feature = "toml")]
mod file;
mod identity;
mod options;
pub mod paper;
mod printed;
mod quantity;
mod unknown;

use std::collections::{BTreeMap, BTreeSet};

pub use claim::{
    Claim, ClaimComputation, ClaimEquation, ClaimQuantity, PrintedEntry, PrintedStatement,
    Supposition, Trend, Unknown, Verdict,
};
pub use printed::{Printed, Relation, Rounding};
pub use quantity::{Computed, NAMES, NotComputable};
pub use unknown::RequiredValue;

use crate::decimal::{decimal, significant};
use crate::exact::Rational;
use crate::expr::Expr;
use crate::symbol::Symbol;
use quantity::Evaluator;
use unknown::Trial;

/// A publication and its claims.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Claims {
    /// The publication.
    pub title: String,
    /// Its claims, in the order in which they are printed.
    pub claims: Vec<Claim>,
}

/// The claims of a publication with their findings.
#[derive(Clone, Debug, PartialEq)]
pub struct Audit {
    /// The publication.
    pub title: String,
    /// A finding for each claim, in the order of the claims.
    pub findings: Vec<ClaimFinding>,
}

/// The result for one claim.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClaimFinding {
    /// The claim.
    pub claim: Claim,
    /// The verdict.
    pub verdict: Verdict,
    /// The attempts, that of the claim alone first; the last one reproduces the claim if any does.
    pub tried: Vec<ClaimAttempt>,
    /// The value of the unknown that the claim requires, if it was solved for.
    pub demand: Option<RequiredValue>,
    /// Quantities that are needed and not printed, if they decide the verdict.
    pub missing: Vec<String>,
    /// The reasons for the verdict, sentence by sentence.
    pub evidence: Vec<String>,
}

/// A claim computed under some suppositions.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimAttempt {
    /// The suppositions; empty for the claim alone.
    pub supposing: Vec<Supposition>,
    /// The suppositions in words, and the value of an unknown that was solved for.
    pub words: Vec<String>,
    /// The computed value of each entry, or the reason why there is none.
    pub computed: Vec<Result<Computed, NotComputable>>,
    /// Whether each entry is reproduced.
    pub reproduced: Vec<bool>,
}

impl ClaimAttempt {
    /// Whether every entry is reproduced.
    pub fn is_reproduced(&self) -> bool {
        self.reproduced.iter().all(|entry| *entry)
    }

    /// The suppositions in one line.
    fn in_a_line(&self) -> String {
        self.words.join(" and ")
    }
}

impl ClaimFinding {
    /// The assumption under which the claim is reproduced; empty if there is none.
    pub fn assumption(&self) -> String {
        if self.verdict != Verdict::UnderAssumption {
            return String::new();
        }
        self.displayed_attempt().map(ClaimAttempt::in_a_line).unwrap_or_default()
    }

    /// The attempt to be shown: one that reproduces the claim, or that of the claim alone.
    pub fn displayed_attempt(&self) -> Option<&ClaimAttempt> {
        let best = self.tried.iter().find(|tried| tried.is_reproduced());
        best.or(self.tried.first())
    }

    /// Whether the verdict is the expected one: a claim without an expected verdict should be
    /// reproduced.
    pub fn is_as_expected(&self) -> bool {
        match self.claim.expected {
            Some(expected) => self.verdict == expected,
            None => self.verdict.is_reproduced(),
        }
    }
}

impl Audit {
    /// Number of claims with this verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.findings.iter().filter(|finding| finding.verdict == verdict).count()
    }

    /// Whether every verdict is the expected one; with `strict`, whether every claim is reproduced,
    /// whatever is expected.
    pub fn passes(&self, strict: bool) -> bool {
        let passes = |finding: &ClaimFinding| match strict {
            true => finding.verdict.is_reproduced(),
            false => finding.is_as_expected(),
        };
        self.findings.iter().all(passes)
    }
}

/// Computes every claim, and compares those that share an unknown number.
pub fn audit(claims: Claims) -> Audit {
    let findings = claims.claims.into_iter().map(audit_claim).collect();
    audit_from_findings(claims.title, findings)
}

/// Makes the audit of the findings of all claims, each made by [`audit_claim`]: compares those that
/// share an unknown number.
pub fn audit_from_findings(title: String, mut findings: Vec<ClaimFinding>) -> Audit {
    share_unknowns(&mut findings);
    Audit { title, findings }
}

/// Largest number of combinations of suppositions that are tried.
pub const MOST_COMBINATIONS: usize = 1000;

/// Every choice of at most one supposition of each subject, the fewest first.
fn combinations(subjects: &[Vec<Supposition>]) -> Vec<Vec<&Supposition>> {
    let mut found: Vec<Vec<&Supposition>> = vec![vec![]];
    for subject in subjects {
        let longer: Vec<Vec<&Supposition>> = found
            .iter()
            .flat_map(|chosen| {
                subject.iter().map(move |one| chosen.iter().copied().chain([one]).collect())
            })
            .collect();
        found.extend(longer);
        found.truncate(MOST_COMBINATIONS);
    }
    found.sort_by_key(Vec::len);
    found
}

/// Computes one claim, without a look at the others.
pub fn audit_claim(claim: Claim) -> ClaimFinding {
    let choices = combinations(&claim.suppositions);
    let mut tried: Vec<ClaimAttempt> = Vec::new();
    for chosen in &choices {
        tried.push(attempt(&claim, chosen));
        if tried.last().is_some_and(ClaimAttempt::is_reproduced) {
            break;
        }
    }
    let mut demand = None;
    let is_reproduced = tried.last().is_some_and(ClaimAttempt::is_reproduced);
    if let (Some(unknown), false) = (claim.unknown, is_reproduced) {
        // If a supposition gives the unknown a value, there is nothing to solve for.
        let supplies = |one: &&Supposition| match one {
            Supposition::Values(values) => values.iter().any(|(name, _)| *name == unknown.name),
            _ => false,
        };
        let open = choices.iter().filter(|chosen| !chosen.iter().any(supplies));
        let demands = open.filter_map(|chosen| {
            let found = solve_for(&claim, chosen, unknown)?;
            Some((found, chosen))
        });
        // The first value within its range, or else the first of all.
        let demands: Vec<(RequiredValue, &Vec<&Supposition>)> = demands.collect();
        let within = demands.iter().find(|(found, _)| found.is_within);
        if let Some((found, chosen)) = within {
            let question = claim.question.supposing(chosen);
            let evaluator = Evaluator::new(&question);
            tried.push(compare(
                &claim,
                &question,
                &evaluator,
                chosen,
                Some((unknown.name, found.value)),
            ));
        }
        let shown = within.or(demands.first());
        demand = shown.map(|(found, _)| *found);
        let outside = demands.iter().filter(|_| within.is_none());
        let outside: Vec<String> =
            outside.map(|(found, chosen)| outside_words(found, &claim.question, chosen)).collect();
        return finding(claim, tried, demand, outside);
    }
    finding(claim, tried, demand, vec![])
}

/// The value of the unknown that a claim requires, in words, if it lies outside of its range.
fn outside_words(
    demand: &RequiredValue,
    question: &ClaimComputation,
    chosen: &[&Supposition],
) -> String {
    let [low, high] = demand.unknown.within.map(|end| significant(end, 3));
    let supposed = match words(question, chosen, None).join(" and ") {
        none if none.is_empty() => none,
        some => format!("{some}: "),
    };
    format!(
        "{supposed}it would need {} = {}, but that lies between {low} and {high}",
        demand.unknown.name,
        significant(demand.value, 3)
    )
}

/// The claim under these suppositions.
fn attempt(claim: &Claim, chosen: &[&Supposition]) -> ClaimAttempt {
    let question = claim.question.supposing(chosen);
    let evaluator = Evaluator::new(&question);
    // Quantities that are not printed must be supposed before anything can be computed.
    let supplied =
        chosen.iter().any(|one| !matches!(one, Supposition::Rounding(_) | Supposition::Pi(_)));
    if !claim.needs.is_empty() && !supplied {
        let needs: BTreeSet<String> = claim.needs.iter().cloned().collect();
        return ClaimAttempt {
            supposing: chosen.iter().map(|one| (*one).clone()).collect(),
            words: words(&question, chosen, None),
            computed: claim
                .entries
                .iter()
                .map(|_| Err(NotComputable::Missing(needs.clone())))
                .collect(),
            reproduced: vec![false; claim.entries.len()],
        };
    }
    compare(claim, &question, &evaluator, chosen, None)
}

/// The suppositions in words, with the numbers that follow from the values of the claim, and the
/// value of an unknown.
fn words(
    question: &ClaimComputation,
    chosen: &[&Supposition],
    unknown: Option<(Symbol, f64)>,
) -> Vec<String> {
    let number = |value: &Expr| {
        let found = identity::with_definitions(value, &question.values).ok()?;
        let is_plain = value.symbols().is_empty();
        let number = found.evaluate(&BTreeMap::new()).ok().filter(|_| !is_plain)?;
        Some(format!(" = {}", decimal(number)))
    };
    let one = |supposition: &&Supposition| match supposition {
        Supposition::Values(values) => {
            let each = values.iter().map(|(name, value)| {
                let text = Supposition::Values(vec![(*name, value.clone())]).to_string();
                text + &number(value).unwrap_or_default()
            });
            each.collect::<Vec<_>>().join(", ")
        }
        other => other.to_string(),
    };
    let solved = unknown.map(|(name, value)| format!("{name} = {}", significant(value, 4)));
    chosen.iter().map(one).chain(solved).collect()
}

/// Computes every entry and compares it with what is printed.
fn compare(
    claim: &Claim,
    question: &ClaimComputation,
    evaluator: &Evaluator,
    chosen: &[&Supposition],
    unknown: Option<(Symbol, f64)>,
) -> ClaimAttempt {
    let computed: Vec<Result<Computed, NotComputable>> =
        claim.entries.iter().map(|entry| evaluator.compute(&entry.values, unknown)).collect();
    let numbers: Option<Vec<f64>> =
        computed.iter().map(|found| found.as_ref().ok()?.number()).collect();
    let comes_out = |(entry, found): (&PrintedEntry, &Result<Computed, NotComputable>)| match (
        &entry.stated,
        found,
    ) {
        (PrintedStatement::Number(printed), Ok(Computed::Number(number))) => {
            printed.is_reproduced_by(*number, question.rounding, question.tolerance)
        }
        (PrintedStatement::Number(printed), Ok(Computed::Exact(number))) => {
            printed.is_reproduced_exactly_by(number, question.rounding, question.tolerance)
        }
        (PrintedStatement::Number(printed), Ok(Computed::Absent)) => printed
            .is_reproduced_exactly_by(&Rational::default(), question.rounding, question.tolerance),
        (PrintedStatement::Formula(printed), Ok(Computed::Formula(formula))) => {
            let printed = identity::with_definitions(printed, &question.values);
            printed
                .and_then(|printed| identity::difference(&printed, formula))
                .is_ok_and(|rest| rest.is_none())
        }
        (PrintedStatement::Trend(trend), Ok(_)) => {
            let same = question.tolerance.unwrap_or(SAME);
            numbers.as_ref().is_some_and(|numbers| trend.holds(numbers, same))
        }
        (PrintedStatement::Words, Ok(Computed::Conflicts(conflicts))) => conflicts.is_empty(),
        _ => false,
    };
    ClaimAttempt {
        supposing: chosen.iter().map(|one| (*one).clone()).collect(),
        words: words(question, chosen, unknown),
        reproduced: claim.entries.iter().zip(&computed).map(comes_out).collect(),
        computed,
    }
}

/// Default relative difference up to which numbers neither rise nor fall.
pub const SAME: f64 = 1e-3;

/// The unknown of a claim, under these suppositions.
fn solve_for(claim: &Claim, chosen: &[&Supposition], unknown: Unknown) -> Option<RequiredValue> {
    let question = claim.question.supposing(chosen);
    let evaluator = Evaluator::new(&question);
    unknown::solve(unknown, &|value| {
        let found = compare(claim, &question, &evaluator, chosen, Some((unknown.name, value)));
        let differences = claim.entries.iter().zip(&found.computed).map(|(entry, found)| {
            let (PrintedStatement::Number(printed), Ok(found)) = (&entry.stated, found) else {
                return f64::NAN;
            };
            found.number().map_or(f64::NAN, |number| number - printed.middle(question.rounding))
        });
        Trial { differences: differences.collect(), reproduces: found.is_reproduced() }
    })
}

/// The verdict that follows from the attempts.
fn finding(
    claim: Claim,
    tried: Vec<ClaimAttempt>,
    demand: Option<RequiredValue>,
    outside: Vec<String>,
) -> ClaimFinding {
    let alone = tried.first();
    let best = tried.iter().find(|tried| tried.is_reproduced());
    let mut missing: BTreeSet<String> = BTreeSet::new();
    let mut refusal = None;
    if best.is_none() {
        for found in alone.iter().flat_map(|tried| &tried.computed) {
            match found {
                Err(NotComputable::Missing(names)) => missing.extend(names.iter().cloned()),
                Err(NotComputable::Refused(reason)) => refusal = Some(reason.clone()),
                Ok(_) => {}
            }
        }
        // An unknown that is solved for is not missing.
        if let Some(unknown) = claim.unknown {
            missing.remove(unknown.name.name());
        }
    }
    let solved = demand.is_some_and(|demand| demand.is_within);
    let verdict = match best {
        Some(best) if best.supposing.is_empty() && !solved => Verdict::Reproduced,
        Some(_) => Verdict::UnderAssumption,
        None if !missing.is_empty() || refusal.is_some() => Verdict::NotReproducible,
        None => Verdict::Inconsistent,
    };
    let mut evidence = Vec::new();
    if !missing.is_empty() {
        let names: Vec<String> = missing.iter().cloned().collect();
        evidence.push(format!("not printed: {}", names.join(", ")));
    }
    evidence.extend(refusal);
    evidence.extend(outside);
    match (best, verdict) {
        (None, Verdict::Inconsistent) if demand.is_none() => {
            evidence.extend(
                alone.map(|alone| computed_versus_printed(&claim, alone)).unwrap_or_default(),
            );
        }
        _ => {}
    }
    evidence.extend(other_attempts(&claim, &tried));
    if let Some(demand) = demand.filter(|demand| demand.is_within && best.is_some()) {
        let name = demand.unknown.name;
        let [low, high] = demand.unknown.within.map(|end| significant(end, 3));
        let [least, greatest] = demand.range.map(|end| significant(end, 4));
        evidence.push(format!(
            "{name} is not printed; every {name} from {least} to {greatest} makes it come out, of those from {low} to {high}"
        ));
    }
    ClaimFinding { missing: missing.into_iter().collect(), evidence, claim, verdict, tried, demand }
}

/// The computed values compared with the printed ones, in words.
fn computed_versus_printed(claim: &Claim, tried: &ClaimAttempt) -> Vec<String> {
    let several = claim.entries.len() > 1;
    if several && tried.reproduced.iter().any(|entry| *entry) {
        let count = tried.reproduced.iter().filter(|entry| **entry).count();
        return vec![format!("{count} of {} entries come out", claim.entries.len())];
    }
    if let Some(PrintedStatement::Trend(_)) = claim.entries.first().map(|entry| &entry.stated) {
        return vec![format!("computed: {}", numbers_of(claim, tried))];
    }
    let entries = claim.entries.iter().zip(&tried.computed);
    let each = entries.flat_map(|(entry, found)| match (&entry.stated, found) {
        (PrintedStatement::Number(_), Ok(Computed::Absent)) => {
            vec![format!("printed {}, but the derived law has no such term", entry.printed)]
        }
        (PrintedStatement::Number(printed), Ok(found)) => {
            let number = found.number().unwrap_or(f64::NAN);
            vec![number_versus_printed(entry, printed, number)]
        }
        (PrintedStatement::Formula(printed), Ok(Computed::Formula(formula))) => {
            let printed = identity::with_definitions(printed, &claim.question.values);
            formula_versus(printed, formula)
        }
        (PrintedStatement::Words, Ok(Computed::Conflicts(conflicts))) => conflicts.clone(),
        _ => vec![],
    });
    each.collect()
}

/// A number compared with the printed one, in words.
fn number_versus_printed(entry: &PrintedEntry, printed: &Printed, number: f64) -> String {
    let read = entry.read_as.as_ref().map_or(String::new(), |text| format!(", read as {text}"));
    let computed = printed.formatted_alike(number, 6);
    let difference = match printed.relation {
        Relation::Equal if number.is_finite() && printed.value * number > 0.0 => {
            let ratio = printed.value / number;
            match ratio {
                0.1..1.0 => format!(
                    ": the printed one is {} % too small",
                    significant(100.0 * (1.0 - ratio), 3)
                ),
                1.0..10.0 => format!(
                    ": the printed one is {} % too large",
                    significant(100.0 * (ratio - 1.0), 3)
                ),
                _ => format!(": the printed one is {} times as large", significant(ratio, 3)),
            }
        }
        _ => String::new(),
    };
    format!("printed {}{read}, computed {computed}{difference}", entry.printed)
}

fn formula_versus(printed: Result<Expr, String>, formula: &Expr) -> Vec<String> {
    let list = |terms: &[Expr]| {
        let words: Vec<String> = terms.iter().map(|term| format!("`{term}`")).collect();
        words.join(", ")
    };
    match printed.and_then(|printed| identity::difference(&printed, formula)) {
        Err(reason) => vec![reason],
        Ok(None) => vec![],
        Ok(Some(rest)) => {
            let printed = (!rest.only_first.is_empty())
                .then(|| format!("printed, but not derived: {}", list(&rest.only_first)));
            let derived = (!rest.only_second.is_empty())
                .then(|| format!("derived, but not printed: {}", list(&rest.only_second)));
            printed.into_iter().chain(derived).collect()
        }
    }
}

/// The coefficient of a term that does not occur, in words.
pub(crate) const ABSENT: &str = "0, no such term";

/// The computed values of all entries.
fn numbers_of(claim: &Claim, tried: &ClaimAttempt) -> String {
    let words = claim.entries.iter().zip(&tried.computed).map(|(entry, found)| match found {
        Ok(Computed::Number(number)) => match &entry.stated {
            PrintedStatement::Number(printed) => printed.formatted_alike(*number, 6),
            _ => decimal(*number),
        },
        Ok(Computed::Exact(fraction)) => fraction.to_string(),
        Ok(Computed::Absent) => ABSENT.to_owned(),
        Ok(Computed::Formula(formula)) => formula.to_string(),
        Ok(Computed::Conflicts(conflicts)) => format!("{} conflicts", conflicts.len()),
        Err(NotComputable::Missing(_)) => "none".to_owned(),
        Err(NotComputable::Refused(reason)) => reason.clone(),
    });
    words.collect::<Vec<_>>().join(", ")
}

/// Largest number of suppositions that are reported.
const TOLD: usize = 8;

/// The results of the other attempts, a sentence each.
fn other_attempts(claim: &Claim, tried: &[ClaimAttempt]) -> Vec<String> {
    let entries = claim.entries.len();
    let is_trend = matches!(
        claim.entries.first().map(|entry| &entry.stated),
        Some(PrintedStatement::Trend(_))
    );
    let told = tried.iter().enumerate().filter(|(index, one)| {
        // The claim alone is reported elsewhere, except for the number of its reproduced entries.
        let worth = *index > 0 || entries > 1 && !is_trend && tried.len() > 1;
        worth && one.computed.iter().any(Result::is_ok)
    });
    let told: Vec<String> = told
        .map(|(_, one)| {
            let words = match one.words.is_empty() {
                true => "as printed".to_owned(),
                false => format!("with {}", one.in_a_line()),
            };
            match (entries, is_trend) {
                (1, _) | (_, true) => format!("{words}: {}", numbers_of(claim, one)),
                _ => {
                    let count = one.reproduced.iter().filter(|entry| **entry).count();
                    format!("{words}: {count} of {entries} come out")
                }
            }
        })
        .collect();
    let left_out = told.len().saturating_sub(TOLD);
    match left_out {
        0 => told,
        _ => {
            // The last attempt is the one that reproduces, if any does.
            let last = told.last().cloned();
            let first = told.into_iter().take(TOLD - 1);
            let between = format!("{left_out} further suppositions do not make it come out");
            first.chain([between]).chain(last).collect()
        }
    }
}

/// Checks that claims that share an unknown require the same values of it.
fn share_unknowns(findings: &mut [ClaimFinding]) {
    let demanded = |finding: &ClaimFinding| {
        finding.demand.filter(|demand| demand.is_within && finding.verdict.is_reproduced())
    };
    let demands: Vec<(usize, String, RequiredValue)> = findings
        .iter()
        .enumerate()
        .filter_map(|(index, finding)| Some((index, finding.claim.id.clone(), demanded(finding)?)))
        .collect();
    for (index, _, demand) in &demands {
        let name = demand.unknown.name;
        let others = demands
            .iter()
            .filter(|(other, _, of_other)| other != index && of_other.unknown.name == name);
        let (with, against): (Vec<_>, Vec<_>) = others.partition(|(_, _, of_other)| {
            unknown::in_common(&[demand.range, of_other.range]).is_some()
        });
        let finding = &mut findings[*index];
        let range =
            |demand: &RequiredValue| demand.range.map(|end| significant(end, 4)).join(" to ");
        if let Some((_, id, of_other)) = against.first() {
            finding.verdict = Verdict::Inconsistent;
            finding.evidence.push(format!(
                "it asks for {name} from {}, but `{id}` for {name} from {}: there is one {name}",
                range(demand),
                range(of_other)
            ));
        } else if !with.is_empty() {
            let ranges: Vec<[f64; 2]> =
                with.iter().map(|(_, _, of_other)| of_other.range).chain([demand.range]).collect();
            let ids: Vec<String> = with.iter().map(|(_, id, _)| format!("`{id}`")).collect();
            if let Some(common) = unknown::in_common(&ranges) {
                let [low, high] = common.map(|end| significant(end, 4));
                finding.evidence.push(format!(
                    "one {name} from {low} to {high} serves {} as well",
                    ids.join(", ")
                ));
            }
        }
    }
}

//! `lindstedt audit FILE` and `lindstedt paper`.

use std::path::{Path, PathBuf};

use crate::audit::{Claim, ClaimFinding, Claims, audit_claim, audit_from_findings};
use crate::export::json;
use crate::export::json::points::ClaimPoint;
use crate::export::json::shard::Shard;
use crate::problem::ProblemError;
use crate::report;
use crate::verify::Verdict;
use clap::Args;

use super::answer::{Answer, no_such};
use super::files::{is_standard, width};
use super::progress::PartsBar;
use super::session;
use super::shard::{self, Points, ShardArguments};
use super::{Common, Failure, Format, Outcome, Work, json_text, read};

/// Every claim of the paper, the file that `lindstedt paper` runs.
const PAPER: &str = include_str!("../../examples/audit/paper.toml");

/// The template of the bar of claims.
const CLAIMS: &str = "{bar:40} {pos}/{len} claims, {eta} left";

/// Claims of a publication from a file, each computed again, with a verdict
#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
pub struct AuditArguments {
    /// A TOML file of claims, or - for standard input
    pub file: PathBuf,
    #[command(flatten)]
    own: StrictArguments,
    #[command(flatten)]
    pub common: Common,
}

/// Every number, equation, table and figure of the paper, computed again, with a verdict
#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
pub struct PaperArguments {
    #[command(flatten)]
    own: StrictArguments,
    #[command(flatten)]
    pub common: Common,
}

#[derive(Args)]
struct StrictArguments {
    /// Exit with code 3 for every claim that is not reproduced, also where the file expects so
    #[arg(long)]
    strict: bool,
    #[command(flatten)]
    shard: ShardArguments,
}

impl Work for AuditArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn input(&self) -> Option<&Path> {
        Some(&self.file)
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &AuditArguments) -> Result<Outcome, Failure> {
    let text = read(&arguments.file)?;
    let name = match is_standard(&arguments.file) {
        true => "standard input".into(),
        false => arguments.file.to_string_lossy(),
    };
    outcome(&text, &name, &arguments.own, &arguments.common)
}

impl Work for PaperArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run_paper(self)
    }
}

fn run_paper(arguments: &PaperArguments) -> Result<Outcome, Failure> {
    outcome(PAPER, "the paper", &arguments.own, &arguments.common)
}

fn outcome(
    claims: &str,
    name: &str,
    own: &StrictArguments,
    common: &Common,
) -> Result<Outcome, Failure> {
    if common.tolerance.is_some() {
        return Err(Failure::Usage(
            "--tolerance: each claim has its own digits, or a tolerance in the file".to_owned(),
        ));
    }
    if common.plot.is_some() {
        return Err(Failure::Usage("--plot: an audit draws no picture".to_owned()));
    }
    let claims: Claims = claims.parse().map_err(|error: ProblemError| {
        Failure::refused(&format!("{name}: {error}"), error.help()).of_kind(&error)
    })?;
    if let Some(shard) = own.shard.shard {
        return write_shard(shard, common, &claims);
    }
    let audit = match shard::known::<ClaimPoint>(claims.claims.len())? {
        None => audit_from_findings(claims.title, findings(claims.claims)?),
        Some(rows) => {
            let read = |(index, (claim, row)): (usize, (Claim, ClaimPoint))| {
                row.read(claim).ok_or_else(|| shard::unreadable(index))
            };
            let findings = claims.claims.into_iter().zip(rows).enumerate().map(read);
            audit_from_findings(claims.title, findings.collect::<Result<_, _>>()?)
        }
    };
    let answer = Answer {
        document: &report::audit(&audit),
        width: width(common.output.as_deref()),
        picture: None,
        other: &|format| match format {
            Format::Json => json_text(&json::audit(&audit)),
            format => no_such(format),
        },
    };
    Ok(Outcome {
        verdict: Some(Verdict::from_passed(audit.passes(own.strict))),
        ..answer.outcome(common)?
    })
}

/// The findings of claims, each made by [`audit_claim`].
///
/// # Errors
/// The interrupt, for which nobody waits: an audit has no parts.
fn findings(claims: Vec<Claim>) -> Result<Vec<ClaimFinding>, Failure> {
    let interrupt = session::interrupt();
    let bar = PartsBar::new(claims.len(), CLAIMS);
    let mut found = Vec::with_capacity(claims.len());
    for claim in claims {
        if interrupt.is_requested() {
            bar.finish();
            return Err(Failure::because("interrupted"));
        }
        found.push(audit_claim(claim));
        bar.advance(1);
    }
    bar.finish();
    Ok(found)
}

/// The lines of the claims of a shard.
fn write_shard(shard: Shard, common: &Common, claims: &Claims) -> Result<Outcome, Failure> {
    let inputs = |index: usize| {
        let id = claims.claims.get(index).map(|claim| claim.id.clone());
        [("claim".to_owned(), id.into())].into_iter().collect()
    };
    let points = Points { total: claims.claims.len(), together: 1, bar: CLAIMS, inputs: &inputs };
    shard::write(shard, common, &points, |indices| {
        let claims = indices.iter().filter_map(|index| claims.claims.get(*index));
        let row = |claim: &Claim| Some(ClaimPoint::from_finding(&audit_claim(claim.clone())));
        Ok(claims.map(row).collect())
    })
}

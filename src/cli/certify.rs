//! `lindstedt certify PROBLEM` and `lindstedt check FILE`.

use std::path::PathBuf;

use clap::Args;
use lindstedt::certificate;
use lindstedt::export::json::{self, CertificateDocument};
use lindstedt::export::{latex, text};
use lindstedt::report::{self, CertificateReport};
use lindstedt::verify::Verdict;

use super::derive::{self, Question};
use super::files::width;
use super::{Common, Failure, Format, Outcome, json_text, read_at_most, tolerance, whole};

#[derive(Args)]
#[command(mut_arg("format", super::without_table))]
#[command(mut_arg("plot", |plot| plot.hide(true)))]
#[command(mut_arg("output", |output| output.help("Write the result to this file; if its name ends in .json, the certificate that `check` reads")))]
pub struct Arguments {
    #[command(flatten)]
    pub question: Question,
    #[command(flatten)]
    pub common: Common,
}

#[derive(Args)]
#[command(mut_arg("format", super::without_table))]
#[command(mut_arg("plot", |plot| plot.hide(true)))]
pub struct CheckArguments {
    /// A certificate, as `certify` writes it; - for standard input
    pub file: PathBuf,
    #[command(flatten)]
    pub common: Common,
}

/// A certificate of the most harmonics has so many bytes.
const LARGEST_CERTIFICATE: usize = 16 << 20;

pub fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    derive::with_motion(&arguments.question, &[("a certificate", true)])?;
    let (oscillator, values, solution) = derive::solved(&arguments.question)?;
    let values = values.unwrap_or_default();
    derive::needed(&solution, &values)?;
    let proved = certificate::certify(&oscillator, &solution, &values);
    let (certificate, certified) = proved.map_err(|error| Failure::refused(&error, error.help().map(str::to_owned)))?;
    let report = CertificateReport {
        question: Some((&solution, &values)),
        certificate: &certificate,
        certified: &certified,
        tolerance: tolerance(&arguments.common),
    };
    printed(&report, &arguments.common)
}

pub fn check(arguments: &CheckArguments) -> Result<Outcome, Failure> {
    let file = &arguments.file;
    let refused = |reason: &dyn std::fmt::Display| Failure::Refused(format!("{}: {reason}", file.display()));
    let text = read_at_most(file, LARGEST_CERTIFICATE)?;
    let document: CertificateDocument =
        serde_json::from_str(&text).map_err(|error| refused(&format!("no certificate: {error}")))?;
    let certificate = document
        .read()
        .map_err(|error| refused(&format!("no certificate: {error}")))?;
    let certified = certificate::check(&certificate).map_err(|error| refused(&error))?;
    let report = CertificateReport {
        question: None,
        certificate: &certificate,
        certified: &certified,
        tolerance: tolerance(&arguments.common),
    };
    printed(&report, &arguments.common)
}

fn printed(report: &CertificateReport, common: &Common) -> Result<Outcome, Failure> {
    let document = report::certificate(report);
    // A file of this ending is read by `check`.
    let ending = common.output.as_ref().and_then(|path| path.extension());
    let format = match common.format {
        Format::Text if ending.is_some_and(|ending| ending == "json") => Format::Json,
        format => format,
    };
    let text = match format {
        Format::Text => text::document(&document, width(common.output.as_deref())),
        Format::Latex => latex::document(&document),
        Format::Json => json_text(&json::certificate(report.certificate))?,
        Format::Csv => super::no_table()?,
        Format::Code(language) => super::no_program(language)?,
    };
    if common.plot.is_some() {
        return Err(Failure::Refused(
            "a proof has no picture\n  help: `derive` draws the formula beside the true motion".to_owned(),
        ));
    }
    Ok(Outcome {
        result: whole(text),
        picture: None,
        note: None,
        verdict: report.verdict().or(Some(Verdict::Pass)),
        partial: false,
    })
}

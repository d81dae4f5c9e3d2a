//! A certificate: what has been proved of a motion, and of the formula for it.

use std::borrow::Cow;

use super::solution::law_blocks;
use super::{Block, Document};
use crate::certificate::{Beyond, Certificate, Certified, Enclosure, Errors, Range, Validity, coordinate};
use crate::decimal::{decimal, neighbours, plain_decimal, significant, significant_fraction};
use crate::derivation::Line;
use crate::exact::Rational;
use crate::exact::rational::{from_f64, to_f64};
use crate::expr::Expr;
use crate::solution::Solution;
use crate::values::Values;
use crate::verify::Verdict;

/// A certificate to be reported.
#[derive(Clone, Copy, Debug)]
pub struct CertificateReport<'a> {
    /// The answer that is judged and its values, where they are known: a document has the numbers alone.
    pub question: Option<(&'a Solution, &'a Values)>,
    /// The certificate.
    pub certificate: &'a Certificate,
    /// What it proves.
    pub certified: &'a Certified,
    /// How far the formula is proved to hold, where that was asked for.
    pub validity: Option<&'a Validity>,
    /// The error of the frequency up to which the formula passes.
    pub tolerance: f64,
}

impl CertificateReport<'_> {
    /// Whether the formula is proved to be within the tolerance; `None` where no formula is judged.
    pub fn verdict(&self) -> Option<Verdict> {
        let errors = self.certified.formula.as_ref()?;
        Some(Verdict::of(errors.relative.upper <= self.tolerance))
    }
}

/// The document of a certificate.
///
/// ```
/// use lindstedt::certificate::certify;
/// use lindstedt::report::{CertificateReport, certificate};
/// use lindstedt::{Options, Oscillator, solve};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options::default())?;
/// let at = "A = 3/2".parse()?;
/// let (proof, certified) = certify(&pendulum, &solution, &at)?;
/// let question = Some((&solution, &at));
/// let report = CertificateReport { question, certificate: &proof, certified: &certified, validity: None, tolerance: 0.01 };
/// let text = lindstedt::export::text::document(&certificate(&report), 100);
/// assert!(text.contains("0.86060834667961"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn certificate<'a>(report: &CertificateReport<'a>) -> Document<'a> {
    let certificate = report.certificate;
    let mut sections = match report.question {
        Some((solution, _)) => vec![
            vec![Block::Question(&solution.equation)],
            vec![Block::Title {
                words: solution.title(),
                amplitude: solution.amplitude.in_words(solution.coordinate()),
            }],
            solution
                .law
                .shown()
                .into_iter()
                .flat_map(|law| law_blocks(solution, law))
                .collect(),
        ],
        None => {
            let acceleration = Expr::from(coordinate().derivative().derivative());
            let left = &acceleration + &certificate.force;
            vec![vec![Block::Line(Cow::Owned(Line::equation(left, Expr::zero())))]]
        }
    };
    let letter = report
        .question
        .map_or(coordinate(), |(solution, _)| solution.coordinate());
    let values = report.question.map(|(_, at)| {
        let values: Vec<String> = at.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        values.join(", ")
    });
    let start = &certificate.start;
    let mut blocks = vec![Block::Heading("Proved".to_owned())];
    let at = values.filter(|values| !values.is_empty()).map(|values| ("at", values));
    let mut facts: Vec<(&str, String)> = at.into_iter().collect();
    facts.extend([
        (
            "motion",
            format!("periodic from {letter}(0) = {start}, {letter}'(0) = 0: {letter}(t) = X(omega*t)"),
        ),
        ("omega", enclosed(&report.certified.frequency)),
    ]);
    if let Some(errors) = &report.certified.formula {
        facts.extend(of_formula(errors, report));
    }
    blocks.push(Block::Facts(facts));
    sections.push(blocks);
    sections.extend(report.validity.map(|validity| {
        let heading = Block::Heading("Proved for a range of amplitudes".to_owned());
        vec![heading, Block::Facts(of_range(validity, report.tolerance))]
    }));
    let proof = report.certified.proof;
    let upper = |bound: crate::exact::Bound| above(bound.value());
    sections.push(vec![
        Block::Heading("The proof: exactly one pair (1/omega^2, X) within r of the certificate's".to_owned()),
        Block::Facts(vec![
            ("r", upper(proof.radius)),
            ("defect Y0", upper(proof.defect)),
            ("contraction Z1", upper(proof.contraction)),
            ("curvature Z2", upper(proof.curvature)),
            ("block", block(certificate)),
        ]),
    ]);
    Document { sections }
}

fn of_range(validity: &Validity, tolerance: f64) -> Vec<(&'static str, String)> {
    let amplitude = |value: &Rational| significant(to_f64(value), 6);
    // What is not proved is not said: six digits, the last one towards the inside of the range.
    let from = significant_fraction(&neighbours(&validity.from, 6)[1], 6);
    let to = significant_fraction(&neighbours(&validity.to, 6)[0], 6);
    let within = significant(100.0 * tolerance, 3);
    let beyond = match &validity.beyond {
        Beyond::Asked => None,
        Beyond::Further(place) => Some(format!("omega is off by more at A = {}, proved", amplitude(place))),
        Beyond::Open(place) => Some(format!(
            "at A = {} omega is neither proved to be within nor beyond",
            amplitude(place)
        )),
        Beyond::Unproved(place, reason) => Some(format!("at A = {}: {reason}", amplitude(place))),
        Beyond::Stopped => Some("stopped before the end".to_owned()),
    };
    let proved = format!("omega within {within} % for every A from {} to {}", from, to);
    let proved = match validity.intervals {
        0 => "omega is not proved to be within the tolerance at the first amplitude".to_owned(),
        _ => proved,
    };
    let intervals = format!("{} intervals of A, a proof each", validity.intervals);
    [("range", proved)]
        .into_iter()
        .chain(beyond.map(|words| ("beyond", words)))
        .chain([("proof", intervals)])
        .collect()
}

fn of_formula(errors: &Errors, report: &CertificateReport) -> Vec<(&'static str, String)> {
    let letter = report
        .question
        .map_or(coordinate(), |(solution, _)| solution.coordinate());
    let formula = report.certificate.formula.as_ref();
    let law = formula
        .map(|formula| ("formula", formula.law.clone()))
        .filter(|_| report.question.is_none());
    let percent = Range {
        lower: 100.0 * errors.relative.lower,
        upper: 100.0 * errors.relative.upper,
    };
    let (deviation, drift) = (above(errors.deviation.upper), above(errors.drift.upper));
    let within = significant(100.0 * report.tolerance, 3);
    let verdict = match report.verdict() {
        Some(Verdict::Pass) => format!("pass (omega within {within} %, proved)"),
        _ if errors.relative.lower > report.tolerance => format!("fail (omega beyond {within} %, proved)"),
        _ => format!("fail (omega is not proved to be within {within} %)"),
    };
    law.into_iter()
        .chain([
            ("error of the formula's omega", between(errors.frequency, "")),
            ("relative error", between(percent, " %")),
            ("largest deviation at one phase", between(errors.deviation, "")),
            (
                "deviation in time",
                format!("|{letter}(t) - formula| <= {} + {}*|t| for all t", deviation, drift),
            ),
            ("verdict", verdict),
        ])
        .collect()
}

/// The number with the digits that are known, and how far it may be from what is printed.
fn enclosed(enclosure: &Enclosure) -> String {
    /// More digits are not written, however many are known.
    const MOST: i32 = 34;
    let radius = enclosure.radius.value();
    let known = if radius > 0.0 {
        -radius.log10().floor()
    } else {
        f64::from(MOST)
    };
    let decimals = (known as i32).clamp(0, MOST);
    let value = to_f64(&enclosure.middle);
    let text = plain_decimal(&enclosure.middle, usize::try_from(decimals).unwrap_or(0));
    // What is very large or small is written with fifteen digits.
    let rounding = match (1e-4..1e14).contains(&value) {
        true => 0.5 * 10.0_f64.powi(-decimals),
        false => 1e-14 * value,
    };
    let printed = radius + rounding;
    format!("{text} +- {}", above(printed))
}

/// A number with its two ends, in one where they agree in what is printed.
fn between(range: Range, unit: &str) -> String {
    let middle = decimal(range.lower);
    if range.upper == 0.0 {
        return "none".to_owned();
    }
    if middle == decimal(range.upper) {
        return format!("{middle}{unit}");
    }
    if range.lower == 0.0 || range.upper < 1e-9 {
        return format!("at most {}{unit}", above(range.upper));
    }
    format!("between {}{unit} and {}{unit}", below(range.lower), above(range.upper))
}

/// Four digits, not below.
fn above(value: f64) -> String {
    outward(value, 1)
}

/// Four digits, not above.
fn below(value: f64) -> String {
    outward(value, 0)
}

fn outward(value: f64, side: usize) -> String {
    match from_f64(value) {
        Some(exact) => significant_fraction(&neighbours(&exact, 4)[side], 4),
        None => value.to_string(),
    }
}

fn block(certificate: &Certificate) -> String {
    let harmonics = match certificate.odd {
        true => "odd harmonics",
        false => "harmonics",
    };
    format!(
        "{harmonics} to {}; those of the certificate go to {}",
        certificate.highest,
        certificate.coefficients.len().saturating_sub(1)
    )
}

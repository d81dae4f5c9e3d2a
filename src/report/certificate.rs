//! A certificate: what has been proved of a motion, and of the formula for it.

use std::borrow::Cow;

use super::driven::slow_equations;
use super::solution::law_blocks;
use super::{Block, Document};
use crate::certificate::{
    Beyond, Certificate, Certified, DampedCertificate, Enclosure, Errors, JudgedFormula, Range, Validity, coordinate,
};
use crate::decimal::{decimal, neighbours, plain_decimal, significant, significant_fraction};
use crate::derivation::Line;
use crate::exact::Rational;
use crate::exact::rational::{from_f64, to_f64};
use crate::expr::Expr;
use crate::solution::Solution;
use crate::symbol::Symbol;
use crate::values::Values;
use crate::verify::Verdict;

/// A certificate of either kind.
#[derive(Clone, Copy, Debug)]
pub enum AnyCertificate<'a> {
    /// Of a motion whose energy is conserved.
    Motion(&'a Certificate),
    /// Of a limit cycle, or of a driven motion.
    Damped(&'a DampedCertificate),
}

impl<'a> From<&'a Certificate> for AnyCertificate<'a> {
    fn from(certificate: &'a Certificate) -> Self {
        Self::Motion(certificate)
    }
}

impl<'a> From<&'a DampedCertificate> for AnyCertificate<'a> {
    fn from(certificate: &'a DampedCertificate) -> Self {
        Self::Damped(certificate)
    }
}

impl AnyCertificate<'_> {
    fn formula(&self) -> Option<&JudgedFormula> {
        match self {
            Self::Motion(certificate) => certificate.formula.as_ref(),
            Self::Damped(certificate) => certificate.formula.as_ref(),
        }
    }

    /// The left side of its equation.
    fn left_side(&self) -> Expr {
        let velocity = coordinate().derivative();
        let acceleration = Expr::from(velocity.derivative());
        match self {
            Self::Motion(certificate) => &acceleration + &certificate.force,
            Self::Damped(certificate) => {
                let drag = &certificate.damping * &Expr::from(velocity);
                &(&acceleration + &drag) + &certificate.force_in_time()
            }
        }
    }

    /// What is proved to be periodic, in a letter.
    fn motion(&self, letter: Symbol) -> String {
        match self {
            Self::Motion(certificate) => format!(
                "periodic from {letter}(0) = {}, {letter}'(0) = 0: {letter}(t) = X(omega*t)",
                certificate.start
            ),
            Self::Damped(certificate) => match &certificate.drive {
                None => format!("a limit cycle: {letter}(t) = X(omega*t)"),
                Some(drive) if drive.periods == 1 => {
                    format!(
                        "periodic with the drive, of the frequency {}: {letter}(t) = X(Omega*t)",
                        drive.frequency
                    )
                }
                Some(drive) => format!(
                    "periodic with {periods} periods of the drive, of the frequency {}: {letter}(t) = X(Omega*t/{periods})",
                    drive.frequency,
                    periods = drive.periods
                ),
            },
        }
    }

    /// What is within r of the numbers of the certificate.
    fn unknowns(&self) -> &'static str {
        match self {
            Self::Motion(_) => "pair (1/omega^2, X)",
            Self::Damped(certificate) if certificate.drive.is_some() => "motion X",
            Self::Damped(_) => "pair (1/omega, X)",
        }
    }

    /// The harmonic of a driven motion whose amplitude is meant.
    fn harmonic(&self) -> Option<usize> {
        match self {
            Self::Motion(_) => None,
            Self::Damped(certificate) => certificate.drive.as_ref().map(|drive| drive.harmonic),
        }
    }

    fn block(&self) -> String {
        let (odd, highest, harmonics) = match self {
            Self::Motion(certificate) => (certificate.odd, certificate.highest, certificate.coefficients.len()),
            Self::Damped(certificate) => (
                certificate.odd,
                certificate.highest,
                certificate.cosines.len().max(certificate.sines.len()),
            ),
        };
        let kind = if odd { "odd harmonics" } else { "harmonics" };
        format!(
            "{kind} to {highest}; those of the certificate go to {}",
            harmonics.saturating_sub(1)
        )
    }
}

/// A certificate to be reported.
#[derive(Clone, Copy, Debug)]
pub struct CertificateReport<'a> {
    /// The answer that is judged and its values, where they are known: a document has the numbers alone.
    pub question: Option<(&'a Solution, &'a Values)>,
    /// The certificate.
    pub certificate: AnyCertificate<'a>,
    /// What it proves.
    pub certified: &'a Certified,
    /// How far the formula is proved to hold, where that was asked for.
    pub validity: Option<&'a Validity>,
    /// The error of the frequency, of a driven motion that of the amplitude, up to which the formula passes.
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
/// let report = CertificateReport { question, certificate: (&proof).into(), certified: &certified, validity: None, tolerance: 0.01 };
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
            match (&solution.response, &solution.modulation) {
                (Some(response), Some(slow)) => slow_equations(solution, response, slow),
                _ => {
                    let law = solution.law.shown().into_iter();
                    law.flat_map(|law| law_blocks(solution, law)).collect()
                }
            },
        ],
        None => {
            let left = certificate.left_side();
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
    let mut blocks = vec![Block::Heading("Proved".to_owned())];
    let at = values.filter(|values| !values.is_empty()).map(|values| ("at", values));
    let mut facts: Vec<(&str, String)> = at.into_iter().collect();
    facts.push(("motion", certificate.motion(letter)));
    match (&report.certified.amplitude, certificate.harmonic()) {
        (Some(amplitude), Some(harmonic)) => {
            let of = if harmonic == 1 {
                String::new()
            } else {
                format!("of harmonic {harmonic}: ")
            };
            facts.push(("amplitude", of + &enclosed(amplitude)));
            facts.push(("stability", "not proved".to_owned()));
        }
        _ => facts.push(("omega", enclosed(&report.certified.frequency))),
    }
    if let Some(exponent) = &report.certified.exponent {
        let phase = "at t = 0 the first harmonic, of the motion and of the formula, is a positive cosine".to_owned();
        facts.insert(facts.len() - 1, ("phase", phase));
        facts.push(("stability", stability(exponent)));
    }
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
        Block::Heading(format!(
            "The proof: exactly one {} within r of the certificate's",
            certificate.unknowns()
        )),
        Block::Facts(vec![
            ("r", upper(proof.radius)),
            ("defect Y0", upper(proof.defect)),
            ("contraction Z1", upper(proof.contraction)),
            ("curvature Z2", upper(proof.curvature)),
            ("block", certificate.block()),
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
    let formula = report.certificate.formula();
    let law = formula
        .map(|formula| ("formula", formula.law.clone()))
        .filter(|_| report.question.is_none());
    let percent = Range {
        lower: 100.0 * errors.relative.lower,
        upper: 100.0 * errors.relative.upper,
    };
    let within = significant(100.0 * report.tolerance, 3);
    let what = if errors.amplitude.is_some() {
        "amplitude"
    } else {
        "omega"
    };
    let verdict = match report.verdict() {
        Some(Verdict::Pass) => format!("pass ({what} within {within} %, proved)"),
        _ if errors.relative.lower > report.tolerance => format!("fail ({what} beyond {within} %, proved)"),
        _ => format!("fail ({what} is not proved to be within {within} %)"),
    };
    let verdict = ("verdict", verdict);
    let deviation = above(errors.deviation.upper);
    let facts = match errors.amplitude {
        Some(amplitude) => vec![
            ("error of the formula's amplitude", between(amplitude, "")),
            ("relative error", between(percent, " %")),
            ("largest deviation", between(errors.deviation, "")),
            verdict,
        ],
        None => vec![
            ("error of the formula's omega", between(errors.frequency, "")),
            ("relative error", between(percent, " %")),
            ("largest deviation at one phase", between(errors.deviation, "")),
            (
                "deviation in time",
                format!(
                    "|{letter}(t) - formula| <= {deviation} + {}*|t| for all t",
                    above(errors.drift.upper)
                ),
            ),
            verdict,
        ],
    };
    law.into_iter().chain(facts).collect()
}

/// Whether the cycle attracts, as far as that is proved.
fn stability(exponent: &Enclosure) -> String {
    let radius = exponent.radius.value();
    let value = to_f64(&exponent.middle);
    let words = match value {
        // Two units in the last place of the double are added.
        value if value.abs() * (1.0 - 4.0 * f64::EPSILON) <= radius => "not proved",
        value if value < 0.0 => "attracts, proved",
        _ => "repels, proved",
    };
    format!("{words}: characteristic exponent {}", enclosed(exponent))
}

/// The number with the digits that are known, and how far it may be from what is printed.
pub(super) fn enclosed(enclosure: &Enclosure) -> String {
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
    let rounding = match (1e-4..1e14).contains(&value.abs()) {
        true => 0.5 * 10.0_f64.powi(-decimals),
        false => 1e-14 * value.abs(),
    };
    let printed = radius + rounding;
    format!("{text} +- {}", above(printed))
}

/// A number with its two ends, in one where they agree in what is printed.
pub(super) fn between(range: Range, unit: &str) -> String {
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

//! A certificate: the proved statements about a motion, and about the formula for it.

use std::borrow::Cow;

use num_traits::{Signed as _, Zero as _};

use super::driven::slow_equations;
use super::modes::{modes_in_formulas, notes_on_rounding};
use super::solution::law_blocks;
use super::{Block, Document};
use crate::certificate::{
    Certificate, Certified, CoupledCertificate, DampedCertificate, Enclosure, Errors,
    JudgedFormula, ModeAmplitude, ModeCertificate, Multipliers, RangeEnd, SizeBounds, Stability,
    Validity, coordinate,
};
use crate::decimal::{
    as_typed, exact_decimal, neighbours, not_above_typed, plain_decimal, plain_fraction,
    rounded_fraction, rounded_up, significant_fraction,
};
use crate::derivation::DerivationLine;
use crate::exact::bound::Bound;
use crate::exact::rational::{from_f64, to_f64};
use crate::exact::{Integer, Rational};
use crate::expr::Expr;
use crate::modes::NormalModes;
use crate::solution::{Note, Solution, constant_in_words};
use crate::spelling::printable_in_line;
use crate::symbol::Symbol;
use crate::values::Values;
use crate::verify::Verdict;

/// A certificate of any kind.
#[derive(Clone, Copy, Debug)]
pub enum AnyCertificate<'a> {
    /// The certificate of a motion whose energy is conserved.
    Motion(&'a Certificate),
    /// The certificate of a limit cycle, or of a driven motion.
    Damped(&'a DampedCertificate),
    /// The certificate of a free motion of several coordinates.
    Mode(&'a ModeCertificate),
    /// The certificate of a limit cycle, or of a driven motion, of several coordinates.
    Coupled(&'a CoupledCertificate),
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

impl<'a> From<&'a CoupledCertificate> for AnyCertificate<'a> {
    fn from(certificate: &'a CoupledCertificate) -> Self {
        Self::Coupled(certificate)
    }
}

impl<'a> From<&'a ModeCertificate> for AnyCertificate<'a> {
    fn from(certificate: &'a ModeCertificate) -> Self {
        Self::Mode(certificate)
    }
}

/// The answer that a certificate judges, and the values at which it does.
#[derive(Clone, Copy, Debug)]
pub enum CertifiedQuestion<'a> {
    /// An answer to an equation of one coordinate.
    Formula(&'a Solution, &'a Values),
    /// The normal modes of coupled equations, of which there is one.
    Mode(&'a NormalModes, &'a Values),
    /// The steady motion of several coordinates to which the motion from rest comes, or the limit
    /// cycle to which that from small displacements comes, without a formula.
    FromRest(&'a Values),
}

impl<'a> CertifiedQuestion<'a> {
    /// The answer of one coordinate; `None` for several.
    pub(crate) const fn solution(self) -> Option<&'a Solution> {
        match self {
            Self::Formula(solution, _) => Some(solution),
            Self::Mode(..) | Self::FromRest(_) => None,
        }
    }

    /// The values.
    const fn values(self) -> &'a Values {
        match self {
            Self::Formula(_, values) | Self::Mode(_, values) | Self::FromRest(values) => values,
        }
    }
}

impl AnyCertificate<'_> {
    fn formula(&self) -> Option<&JudgedFormula> {
        match self {
            Self::Motion(certificate) => certificate.formula.as_ref(),
            Self::Damped(certificate) => certificate.formula.as_ref(),
            Self::Mode(certificate) => certificate.formula.as_ref(),
            Self::Coupled(_) => None,
        }
    }

    /// The binary digits of its numbers.
    const fn bits(&self) -> usize {
        match self {
            Self::Motion(certificate) => certificate.bits,
            Self::Damped(certificate) => certificate.bits,
            Self::Mode(certificate) => certificate.bits,
            Self::Coupled(certificate) => certificate.bits,
        }
    }

    /// The left sides of its equations.
    fn left_sides(&self) -> Vec<Expr> {
        let velocity = coordinate().derivative();
        let acceleration = |velocity: Symbol| Expr::from(velocity.derivative());
        match self {
            Self::Motion(certificate) => vec![&acceleration(velocity) + &certificate.force],
            Self::Damped(certificate) => {
                let drag = &certificate.damping * &Expr::from(velocity);
                vec![&(&acceleration(velocity) + &drag) + &certificate.force_in_time()]
            }
            Self::Mode(certificate) => {
                let rows = certificate.coordinates.iter().zip(&certificate.forces);
                rows.map(|(name, force)| &acceleration(name.derivative()) + force).collect()
            }
            Self::Coupled(certificate) => {
                let names = &certificate.coordinates;
                let rows = certificate.damping.iter().zip(certificate.forces_in_time());
                let rows = rows.zip(names).map(|((row, force), name)| {
                    let drag = row.iter().zip(names);
                    let drag = drag.map(|(entry, name)| entry * &Expr::from(name.derivative()));
                    &(&acceleration(name.derivative()) + &drag.sum::<Expr>()) + &force
                });
                rows.collect()
            }
        }
    }

    /// The coordinates, separated by commas; `None` for one coordinate.
    fn coordinates(&self) -> Option<String> {
        match self {
            Self::Motion(_) | Self::Damped(_) => None,
            Self::Mode(certificate) => Some(listed(&certificate.coordinates)),
            Self::Coupled(certificate) => Some(listed(&certificate.coordinates)),
        }
    }

    /// The statement of the proved periodicity, with the symbols of the coordinate and of the
    /// frequency.
    fn motion(&self, letter: Symbol, omega: &str) -> String {
        match self {
            Self::Motion(certificate) => format!(
                "periodic from {letter}(0) = {}, {letter}'(0) = 0: {letter}(t) = X({omega}*t)",
                certificate.start
            ),
            Self::Mode(certificate) => format!(
                "periodic from rest, {} = {}: ({})(t) = X({omega}*t)",
                measured(certificate),
                certificate.amplitude,
                listed(&certificate.coordinates)
            ),
            Self::Coupled(certificate) => {
                let names = listed(&certificate.coordinates);
                let Some(drive) = &certificate.drive else {
                    return format!("a limit cycle: ({names})(t) = X({omega}*t)");
                };
                let (periods, part) = match drive.periods {
                    1 => ("the drive".to_owned(), String::new()),
                    count => (format!("{count} periods of the drive"), format!("/{count}")),
                };
                format!(
                    "periodic with {periods}, of the frequency {}: ({names})(t) = X({omega}*t{part})",
                    drive.frequency,
                )
            }
            Self::Damped(certificate) => match &certificate.drive {
                None => format!("a limit cycle: {letter}(t) = X({omega}*t)"),
                Some(drive) if drive.periods == 1 => {
                    format!(
                        "periodic with the drive, of the frequency {}: {letter}(t) = X({omega}*t)",
                        drive.frequency
                    )
                }
                Some(drive) => format!(
                    "periodic with {periods} periods of the drive, of the frequency {}: {letter}(t) = X({omega}*t/{periods})",
                    drive.frequency,
                    periods = drive.periods
                ),
            },
        }
    }

    /// The object of the proof: exactly one of these is within r of the numbers of the certificate.
    fn unknowns(&self, omega: &str) -> String {
        match self {
            Self::Motion(_) => format!("pair (1/{omega}^2, X), X of cosines,"),
            Self::Mode(certificate) if certificate.odd => {
                format!("pair (1/{omega}^2, X), X of odd cosines,")
            }
            Self::Mode(_) => format!("pair (1/{omega}^2, X), X of cosines,"),
            Self::Coupled(certificate) => match (&certificate.drive, certificate.odd) {
                (Some(_), false) => "motion X".to_owned(),
                (Some(_), true) => "motion X of odd harmonics".to_owned(),
                (None, odd) => format!(
                    "pair (1/{omega}, X), {}the first of {} a cosine,",
                    if odd { "X of odd harmonics and " } else { "" },
                    certificate.coordinates[certificate.phase]
                ),
            },
            Self::Damped(certificate) => match (certificate.drive.is_some(), certificate.odd) {
                (true, false) => "motion X".to_owned(),
                (true, true) => "motion X of odd harmonics".to_owned(),
                (false, false) => format!("pair (1/{omega}, X), the first harmonic a cosine,"),
                (false, true) => {
                    format!("pair (1/{omega}, X), X of odd harmonics and the first a cosine,")
                }
            },
        }
    }

    /// A statement that the theorem leaves open: for odd harmonics alone it does not exclude
    /// motions with even ones. `None` if there is none.
    fn left_open(&self) -> Option<&'static str> {
        match self {
            Self::Damped(certificate) if certificate.odd => {
                Some("of motions with even harmonics nothing is proved: one may be within r too")
            }
            Self::Coupled(certificate) if certificate.odd => {
                Some("of motions with even harmonics nothing is proved: one may be within r too")
            }
            Self::Mode(certificate) if certificate.odd => {
                Some("of motions with even harmonics nothing is proved: one may be within r too")
            }
            _ => None,
        }
    }

    /// The harmonic of a driven motion whose amplitude the formula gives; `None` for other motions.
    fn harmonic(&self) -> Option<usize> {
        match self {
            Self::Motion(_) | Self::Mode(_) => None,
            Self::Damped(certificate) => certificate.drive.as_ref().map(|drive| drive.harmonic),
            Self::Coupled(certificate) => certificate.drive.as_ref().map(|drive| drive.harmonic),
        }
    }

    fn block(&self) -> String {
        let (odd, highest, harmonics) = match self {
            Self::Motion(certificate) => {
                (certificate.odd, certificate.highest, certificate.coefficients.len())
            }
            Self::Damped(certificate) => (
                certificate.odd,
                certificate.highest,
                certificate.cosines.len().max(certificate.sines.len()),
            ),
            Self::Mode(certificate) => (
                certificate.odd,
                certificate.highest,
                certificate.coefficients.iter().map(Vec::len).max().unwrap_or(0),
            ),
            Self::Coupled(certificate) => {
                let lists = certificate.cosines.iter().chain(&certificate.sines);
                (certificate.odd, certificate.highest, lists.map(Vec::len).max().unwrap_or(0))
            }
        };
        let kind = if odd { "odd harmonics" } else { "harmonics" };
        format!(
            "{kind} to {highest}; those of the certificate go to {}",
            harmonics.saturating_sub(1)
        )
    }
}

/// The symbols of coordinates, separated by commas.
fn listed(coordinates: &[Symbol]) -> String {
    let names: Vec<String> = coordinates.iter().map(ToString::to_string).collect();
    names.join(", ")
}

/// The amplitude of a mode in words.
fn measured(certificate: &ModeCertificate) -> String {
    match &certificate.measure {
        ModeAmplitude::Start(coordinate) => format!("{}(0)", certificate.coordinates[*coordinate]),
        ModeAmplitude::FirstHarmonic(factors) => {
            let terms = factors.iter().zip(&certificate.coordinates);
            let sum: Expr = terms.map(|(factor, name)| factor * &Expr::from(*name)).sum();
            format!("first harmonic of {sum}")
        }
    }
}

/// A certificate to be reported.
#[derive(Clone, Copy, Debug)]
pub struct CertificateReport<'a> {
    /// The answer that is judged and its values; `None` for a certificate read from a document,
    /// which has only the numbers.
    pub question: Option<CertifiedQuestion<'a>>,
    /// The certificate.
    pub certificate: AnyCertificate<'a>,
    /// The proved motion and its errors.
    pub certified: &'a Certified,
    /// The range in which the formula is proved to hold, if it was asked for.
    pub validity: Option<&'a Validity>,
    /// The largest error of the frequency, or of the amplitude of a driven motion, with which the
    /// formula passes.
    pub tolerance: f64,
}

impl CertificateReport<'_> {
    /// The symbol of the frequency: that of the formula, or of the drive for a driven motion;
    /// `Omega` if it is unknown or a number.
    fn omega(&self) -> String {
        if self.certificate.harmonic().is_none() {
            let letters = self.certificate.formula().map(|formula| formula.letters);
            return letters.unwrap_or_default().frequency.to_string();
        }
        let solution = self.question.and_then(CertifiedQuestion::solution);
        let slow = solution.and_then(|solution| solution.modulation.as_ref());
        let resonance = slow.and_then(|slow| slow.resonance.as_ref());
        let named = resonance.filter(|resonance| !resonance.driving_frequency.symbols().is_empty());
        named.map_or_else(|| "Omega".to_owned(), |named| named.driving_frequency.to_string())
    }

    /// The symbol of the coordinate.
    fn coordinate(&self) -> Symbol {
        let solution = self.question.and_then(CertifiedQuestion::solution);
        solution.map_or(coordinate(), Solution::coordinate)
    }

    /// Whether the formula is proved to be within the tolerance; `None` if no formula is judged.
    pub fn verdict(&self) -> Option<Verdict> {
        let errors = self.certified.formula.as_ref()?;
        Some(Verdict::from_passed(errors.relative.upper <= not_above_typed(self.tolerance)))
    }
}

/// The document of a certificate.
///
/// ```
/// use lindstedt::certificate::certify;
/// use lindstedt::report::{CertificateReport, CertifiedQuestion, certificate};
/// use lindstedt::{Options, Oscillator, solve};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options::default())?;
/// let at = "A = 3/2".parse()?;
/// let (proof, certified) = certify(&pendulum, &solution, &at)?;
/// let question = Some(CertifiedQuestion::Formula(&solution, &at));
/// let report = CertificateReport { question, certificate: (&proof).into(), certified: &certified, validity: None, tolerance: 0.01 };
/// let text = lindstedt::export::text::document(&certificate(&report), 100);
/// assert!(text.contains("0.86060834667961"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn certificate<'a>(report: &CertificateReport<'a>) -> Document<'a> {
    let certificate = report.certificate;
    let letters = certificate.formula().map(|formula| formula.letters).unwrap_or_default();
    let mut sections = match report.question {
        Some(CertifiedQuestion::Mode(modes, _)) => {
            let mut sections = modes_in_formulas(modes);
            sections.push(notes_on_rounding(modes));
            sections
        }
        Some(CertifiedQuestion::Formula(solution, _)) => vec![
            vec![Block::Question(&solution.equation)],
            vec![Block::Title {
                words: solution.title(),
                amplitude: solution.amplitude.in_words(solution.coordinate()),
            }],
            match (&solution.response, &solution.modulation) {
                (Some(response), Some(slow)) => slow_equations(solution, response, slow),
                _ => {
                    let law = solution.law.display_forms().into_iter();
                    law.flat_map(|law| law_blocks(solution, law)).collect()
                }
            },
            notes_on_letters(solution),
        ],
        Some(CertifiedQuestion::FromRest(_)) | None => {
            let line = |left| Block::Line(Cow::Owned(DerivationLine::equation(left, Expr::zero())));
            vec![certificate.left_sides().into_iter().map(line).collect()]
        }
    };
    sections.retain(|blocks| !blocks.is_empty());
    let letter = report.coordinate();
    let omega = report.omega();
    let values = report.question.map(|question| {
        let values = question.values().iter();
        let values: Vec<String> = values.map(|(name, value)| format!("{name} = {value}")).collect();
        values.join(", ")
    });
    let mut blocks = vec![Block::Heading("Proved".to_owned())];
    let at = values.filter(|values| !values.is_empty()).map(|values| ("at", values));
    let mut facts: Vec<(&str, String)> = at.into_iter().collect();
    facts.push(("motion", certificate.motion(letter, &omega)));
    if let (Some(CertifiedQuestion::FromRest(values)), AnyCertificate::Coupled(coupled)) =
        (report.question, certificate)
    {
        let is_given = coupled.coordinates.iter().any(|name| values.get(*name).is_some());
        let start = match (is_given, &coupled.drive) {
            (true, _) => "rest at these displacements",
            (_, Some(_)) => "rest",
            (_, None) => "rest at small displacements, 1/10, 1/20 and so on,",
        };
        facts.push((
            "chosen",
            format!(
                "the one that the motion from {start} comes to, in numbers; others are not looked for"
            ),
        ));
    }
    match (&report.certified.amplitude, certificate.harmonic()) {
        (Some(amplitude), Some(harmonic)) => {
            let of =
                if harmonic == 1 { String::new() } else { format!("of harmonic {harmonic}: ") };
            facts.push(("amplitude", of + &enclosed(amplitude)));
            facts.push(("stability", stability_of_driven(report.certified.multipliers.as_ref())));
        }
        (None, Some(_)) => {}
        _ => facts.push((letters.frequency.name(), enclosed(&report.certified.frequency))),
    }
    if let AnyCertificate::Coupled(coupled) = certificate {
        let harmonic = coupled.harmonic();
        let of = if harmonic == 1 { String::new() } else { format!("harmonic {harmonic} of ") };
        let all = coupled.coordinates.iter().zip(&report.certified.amplitudes);
        facts.extend(all.map(|(name, amplitude)| {
            ("amplitude", format!("of {of}{name}: {}", enclosed(amplitude)))
        }));
        let along =
            if coupled.drive.is_some() { "" } else { ", but for the one along the motion," };
        facts.push(("stability", stability_of_several(report.certified.stability.as_ref(), along)));
    }
    if let Some(exponent) = &report.certified.exponent {
        let of = match report.certified.formula {
            Some(_) => "of the motion and of the formula",
            None => "of the motion",
        };
        let phase = format!("at t = 0 the first harmonic, {of}, is a positive cosine");
        facts.insert(facts.len() - 1, ("phase", phase));
        facts.push(("stability", stability(exponent)));
    }
    match &report.certified.formula {
        Some(errors) => facts.extend(of_formula(errors, report)),
        None => {
            facts.push(("formula", "none is judged: the proof is of the motion alone".to_owned()))
        }
    }
    blocks.push(Block::Facts(facts));
    sections.push(blocks);
    sections.extend(report.validity.map(|validity| {
        let heading = Block::Heading("Proved for a range of amplitudes".to_owned());
        vec![heading, Block::Facts(of_range(validity, report))]
    }));
    let proof = report.certified.proof;
    let upper = |bound: crate::exact::Bound| rounded_up(bound.value(), 4);
    sections.push(vec![
        Block::Heading(format!(
            "The proof: exactly one {} within r of the certificate's",
            certificate.unknowns(&omega)
        )),
        Block::Facts(
            [
                ("r", upper(proof.radius)),
                ("defect Y0", upper(proof.defect)),
                ("contraction Z1", upper(proof.contraction)),
                ("curvature Z2", upper(proof.curvature)),
                ("block", certificate.block()),
            ]
            .into_iter()
            .chain(certificate.left_open().map(|words| ("left open", words.to_owned())))
            .collect(),
        ),
    ]);
    sections.extend(words_of_file(report));
    Document { sections }
}

/// Notes on symbols that are not the usual ones.
fn notes_on_letters<'a>(solution: &Solution) -> Vec<Block<'a>> {
    let notes = solution.validity.iter();
    let notes = notes.filter(|note| matches!(note, Note::OtherLetter { .. }));
    notes.map(|note| Block::Note(note.to_string())).collect()
}

fn of_range(validity: &Validity, report: &CertificateReport) -> Vec<(&'static str, String)> {
    let letters = report.certificate.formula().map(|formula| formula.letters).unwrap_or_default();
    let (omega, letter) = (letters.frequency, letters.amplitude);
    // The proof holds for exactly this amplitude: it is printed in six digits, or as the fraction.
    let amplitude = |value: &Rational| match rounded_fraction(value, 6) == *value {
        true => significant_fraction(value, 6),
        false => value.to_string(),
    };
    // Only proved amplitudes are printed: six digits, the last one rounded towards the inside of
    // the range.
    let inside = [&neighbours(&validity.from, 6)[1], &neighbours(&validity.to, 6)[0]];
    let [from, to] = match inside[0] <= inside[1] {
        true => inside.map(|end| significant_fraction(end, 6)),
        false => [&validity.from, &validity.to].map(ToString::to_string),
    };
    let within = percent(report.tolerance);
    let beyond = match &validity.beyond {
        RangeEnd::Asked => None,
        RangeEnd::Further(place) => {
            Some(format!("{omega} is off by more at {letter} = {}, proved", amplitude(place)))
        }
        RangeEnd::Open(place) => Some(format!(
            "at {letter} = {} {omega} is neither proved to be within nor beyond",
            amplitude(place)
        )),
        RangeEnd::Unproved(place, reason) => {
            Some(format!("at {letter} = {}: {reason}", amplitude(place)))
        }
        RangeEnd::Stopped => Some("stopped before the end".to_owned()),
    };
    let proved = format!("{omega} within {within} % for every {letter} from {from} to {to}");
    let proved = match validity.intervals {
        0 => format!("{omega} is not proved to be within the tolerance at the first amplitude"),
        _ => proved,
    };
    let intervals = format!("{} intervals of {letter}, a proof each", validity.intervals);
    [("range", proved)]
        .into_iter()
        .chain(beyond.map(|words| ("beyond", words)))
        .chain([("proof", intervals)])
        .collect()
}

fn of_formula(errors: &Errors, report: &CertificateReport) -> Vec<(&'static str, String)> {
    let letter = report.coordinate();
    let omega = report.omega();
    let formula = report.certificate.formula().filter(|_| report.question.is_none());
    let formula = formula.map(|formula| numbers_of(formula, report)).unwrap_or_default();
    let copies = match report.certified.copies {
        1 => None,
        copies => Some((
            "compared with",
            format!(
                "the nearest of {copies} motions that the symmetries of the equation make of X"
            ),
        )),
    };
    let within = percent(report.tolerance);
    let what = if errors.amplitude.is_some() { "amplitude" } else { &omega };
    let verdict = match report.verdict() {
        Some(Verdict::Pass) => format!("pass ({what} within {within} %, proved)"),
        _ if errors.relative.lower > report.tolerance => {
            format!("fail ({what} beyond {within} %, proved)")
        }
        _ => format!("fail ({what} is not proved to be within {within} %)"),
    };
    let verdict = ("verdict", verdict);
    let deviation = rounded_up(errors.deviation.upper, 4);
    let error_of_frequency = match omega.as_str() {
        "omega" => "error of the formula's omega",
        _ => "error of the formula's frequency",
    };
    let facts = match errors.amplitude {
        Some(amplitude) => vec![
            ("error of the formula's amplitude", between(amplitude, "")),
            ("relative error", between_percent(errors.relative)),
            ("largest deviation", between(errors.deviation, "")),
            verdict,
        ],
        None => {
            let (of, whose) = match report.certificate.coordinates() {
                None => (letter.to_string(), String::new()),
                Some(names) => ("q".to_owned(), format!(", q any of {names}")),
            };
            let largest = between(errors.deviation, "");
            vec![
                (error_of_frequency, between(errors.frequency, "")),
                ("relative error", between_percent(errors.relative)),
                ("largest deviation at one phase", largest),
                (
                    "deviation in time",
                    format!(
                        "|{of}(t) - formula| <= {deviation} + {}*|t| for all t{whose}",
                        rounded_up(errors.drift.upper, 4)
                    ),
                ),
                verdict,
            ]
        }
    };
    formula.into_iter().chain(copies).chain(facts).collect()
}

/// The formula of a file: its numbers, which are judged, and its law if that was read and agrees
/// with them.
fn numbers_of(formula: &JudgedFormula, report: &CertificateReport) -> Vec<(&'static str, String)> {
    let values: Vec<String> = formula
        .values
        .iter()
        .map(|(name, value)| format!("{name} = {}", constant_in_words(value)))
        .collect();
    let law = printable_in_line(&formula.law);
    let law = match values.is_empty() {
        true => law,
        false => format!("{law} at {}", values.join(", ")),
    };
    let law = report.certified.law_is_held.then_some(("formula", law));
    let bits = report.certificate.bits();
    let number = |units: &Integer| Rational::new(units.clone(), Integer::from(1) << bits);
    let omega = report.certified.formula.filter(|errors| errors.amplitude.is_none());
    let omega = omega.map(|_| {
        let omega = significant_fraction(&rounded_fraction(&number(&formula.frequency), 12), 12);
        let name = match formula.letters.frequency.name() {
            "omega" => "omega of the formula",
            _ => "frequency of the formula",
        };
        (name, omega)
    });
    let first = displacement([&formula.coefficients, &formula.sines], number);
    let displacement = match report.certificate {
        AnyCertificate::Mode(certificate) => {
            let others = formula.others.iter().map(|list| displacement([list, &[]], number));
            let all = certificate.coordinates.iter().zip(std::iter::once(first).chain(others));
            all.map(|(name, sum)| format!("{name} = {sum}")).collect::<Vec<_>>().join("; ")
        }
        _ => first,
    };
    law.into_iter().chain(omega).chain([("X of the formula", displacement)]).collect()
}

/// The largest harmonics of a motion, rounded, and how many more there are.
fn displacement(units: [&[Integer]; 2], number: impl Fn(&Integer) -> Rational + Copy) -> String {
    /// Largest number of harmonics that are printed.
    const MOST: usize = 5;
    let [cosines, sines] = units.map(|units| units.iter().map(number).collect::<Vec<Rational>>());
    let mut waves: Vec<(usize, &str, Rational)> = vec![];
    for k in 0..cosines.len().max(sines.len()) {
        for (name, list) in [("cos", &cosines), ("sin", &sines)] {
            waves.extend(
                list.get(k).filter(|value| !value.is_zero()).map(|value| (k, name, value.clone())),
            );
        }
    }
    let mut sizes: Vec<Rational> = waves.iter().map(|(.., value)| value.abs()).collect();
    sizes.sort_by(|one, other| other.cmp(one));
    let smallest = sizes.get(MOST - 1).or(sizes.last()).cloned().unwrap_or_default();
    let (shown, others): (Vec<_>, Vec<_>) =
        waves.into_iter().partition(|(.., value)| value.abs() >= smallest);
    let term = |(k, name, value): &(usize, &str, Rational)| {
        let size = significant_fraction(&rounded_fraction(&value.abs(), 6), 6);
        let wave = match k {
            0 => size,
            1 => format!("{size}*{name}(theta)"),
            k => format!("{size}*{name}({k}*theta)"),
        };
        (value.is_negative(), wave)
    };
    let mut text = String::new();
    for (index, (is_negative, wave)) in shown.iter().map(term).enumerate() {
        text += match (index, is_negative) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => " + ",
            (_, true) => " - ",
        };
        text += &wave;
    }
    match (shown.is_empty(), others.len()) {
        (true, _) => "0".to_owned(),
        (false, 0) => text + ", rounded",
        (false, 1) => text + ", rounded, and 1 smaller term",
        (false, more) => format!("{text}, rounded, and {more} smaller terms"),
    }
}

/// Shows the words of a file that were not compared with the numbers.
fn words_of_file<'a>(report: &CertificateReport) -> Option<Vec<Block<'a>>> {
    let formula = report.certificate.formula()?;
    let is_unread =
        report.question.is_none() && !report.certified.law_is_held && !formula.law.is_empty();
    is_unread.then(|| {
        vec![
            Block::Heading("Words of the file, which nothing was held against".to_owned()),
            Block::Facts(vec![("law", printable_in_line(&formula.law))]),
        ]
    })
}

/// The proved stability of the cycle, in words.
fn stability(exponent: &Enclosure) -> String {
    let radius = exponent.radius.value();
    let value = to_f64(&exponent.middle);
    let words = match value {
        // The margin is two units in the last place of the double.
        value if value.abs() * (1.0 - 4.0 * f64::EPSILON) <= radius => "not proved",
        value if value < 0.0 => "attracts, proved",
        _ => "repels, proved",
    };
    format!("{words}: characteristic exponent {}", enclosed(exponent))
}

/// The proved stability of a driven motion, in words.
pub(super) fn stability_of_driven(multipliers: Option<&Multipliers>) -> String {
    let Some(multipliers) = multipliers else {
        return "not proved: the variational equation has no series".to_owned();
    };
    let both = format!(
        "multipliers with the sum {} and the product {}",
        enclosed(&multipliers.trace),
        enclosed(&multipliers.determinant)
    );
    let larger = match &multipliers.largest {
        Some(largest) => {
            format!("the larger Floquet multiplier has the modulus {}", enclosed(largest))
        }
        None => both.clone(),
    };
    match multipliers.attracts {
        Some(true) => format!("attracts, proved: {larger}"),
        Some(false) => format!("unstable, proved: {larger}"),
        None => format!("not proved: |sum| < 1 + product < 2 is not decided, {both}"),
    }
}

/// The proved stability of a motion of several coordinates, in words; `along` excepts a multiplier.
fn stability_of_several(stability: Option<&Stability>, along: &str) -> String {
    let Some((stability, largest)) = stability.and_then(|own| Some((own, own.largest?))) else {
        return "not proved: the variational equation has no series, or is too large".to_owned();
    };
    let verdict = match stability.attracts {
        Some(true) => "attracts, proved",
        Some(false) => "unstable, proved",
        None => "not proved",
    };
    format!(
        "{verdict}: the modulus of the largest Floquet multiplier{along} is {}",
        between(largest, "")
    )
}

/// The number with its known digits, and a bound of its distance from the printed one.
pub(super) fn enclosed(enclosure: &Enclosure) -> String {
    let (text, radius) = known_digits(enclosure);
    format!("{text} +- {}", rounded_up(radius, 4))
}

/// The known digits of a number, and a bound of its distance from what they say.
pub(crate) fn known_digits(enclosure: &Enclosure) -> (String, f64) {
    /// Largest number of printed digits.
    const MOST: i32 = 34;
    let radius = enclosure.radius.value();
    let known = if radius > 0.0 { -radius.log10().floor() } else { f64::from(MOST) };
    let decimals = usize::try_from((known as i32).clamp(0, MOST)).unwrap_or(0);
    let text = plain_decimal(&enclosure.middle, decimals);
    let rounding = (&enclosure.middle - plain_fraction(&enclosure.middle, decimals)).abs();
    // The bound of a sum is rounded up, as its parts are.
    (text, (enclosure.radius + Bound::of_fraction(&rounding)).value())
}

/// A tolerance in percent, exactly.
pub(super) fn percent(tolerance: f64) -> String {
    let percent = as_typed(tolerance) * Integer::from(100);
    exact_decimal(&percent).unwrap_or_else(|| percent.to_string())
}

/// A number with its two ends, each rounded outwards, in one where they agree.
fn between(range: SizeBounds, unit: &str) -> String {
    let ends = [range.lower, range.upper].map(from_f64);
    between_exactly(ends, unit)
}

/// A ratio with its two ends in percent, rounded like those of [`between`].
fn between_percent(range: SizeBounds) -> String {
    let percent = |end: f64| Some(from_f64(end)? * Integer::from(100));
    between_exactly([range.lower, range.upper].map(percent), " %")
}

/// Two ends in words; an end is `None` if it is not known.
fn between_exactly([lower, upper]: [Option<Rational>; 2], unit: &str) -> String {
    /// Digits of ends that agree, and of others.
    const DIGITS: [usize; 2] = [6, 4];
    let lower = lower.unwrap_or_default();
    let Some(upper) = upper else {
        return format!("at least {}{unit}", significant_fraction(&neighbours(&lower, 4)[0], 4));
    };
    if upper.is_zero() {
        return "none".to_owned();
    }
    // A proof has more digits than a double, so that such a small error may be zero.
    let is_small = upper < Rational::new(1.into(), 1_000_000_000.into());
    let agree = rounded_fraction(&lower, DIGITS[0]) == rounded_fraction(&upper, DIGITS[0]);
    let digits = DIGITS[usize::from(!agree)];
    let [below, above] = [&neighbours(&lower, digits)[0], &neighbours(&upper, digits)[1]];
    let text = |end: &Rational| format!("{}{unit}", significant_fraction(end, digits));
    match below == above {
        true => text(above),
        false if lower.is_zero() || is_small && !agree => format!("at most {}", text(above)),
        false => format!("between {} and {}", text(below), text(above)),
    }
}

/// A ratio in percent with six digits if both ends agree in them, else as by [`between`].
pub(super) fn rounded_percent(range: SizeBounds) -> String {
    let percent = |end: f64| Some(rounded_fraction(&(from_f64(end)? * Integer::from(100)), 6));
    match [range.lower, range.upper].map(percent) {
        [Some(lower), Some(upper)] if lower == upper && !upper.is_zero() => {
            format!("{} %", significant_fraction(&upper, 6))
        }
        _ => between_percent(range),
    }
}

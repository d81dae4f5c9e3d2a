//! The shortest frequency law within an error on a range, and the front of length against error.

use super::certificate::percent;
use super::{Block, Document, size_in_percent};
use crate::certificate::{
    LawCertificate, LawError, LawQuantity, ModeAmplitude, MotionsOfLaw, StartOfLaw, restitution,
};
use crate::decimal::{decimal, significant};
use crate::exact::Rational;
use crate::exact::rational::to_f64;
use crate::expr::Expr;
use crate::shortest::{Front, LawMotion, ShortLaw};
use crate::solution::AmplitudeConvention;
use crate::symbol::Symbol;
use crate::symbol::letters::FREQUENCY;
use crate::verify::Verdict;

/// The result of a search, and the error that was asked for.
#[derive(Clone, Debug)]
pub struct ShortestReport<'a> {
    /// The laws.
    pub front: &'a Front,
    /// The largest error that is asked for; `None` for the front alone.
    pub error: Option<f64>,
    /// The equation of motion as text.
    pub equation: String,
    /// The equation of the law that is shown first, and those of its quantities.
    lines: Vec<String>,
}

impl<'a> ShortestReport<'a> {
    /// A report of a front.
    pub fn new(front: &'a Front, error: Option<f64>) -> Self {
        let equation = front.problem.equation.clone();
        let mut report = Self { front, error, equation, lines: vec![] };
        let law = report.shown();
        report.lines = law.map_or_else(Vec::new, |law| report.lines_of(law));
        report
    }

    /// The number of the shortest law within the error, or of the best one where no error is asked for.
    pub fn chosen(&self) -> Option<usize> {
        let laws = &self.front.laws;
        match self.error {
            Some(error) => {
                laws.iter().position(|law| law.proof.is_ok() && law.largest_error() <= error)
            }
            None => laws.len().checked_sub(1),
        }
    }

    /// The law that is shown first: the shortest one within the error, or else the one nearest to it.
    pub fn shown(&self) -> Option<&'a ShortLaw> {
        let front = self.front;
        let within = self.error.and_then(|error| front.shortest_within(error));
        self.chosen().map(|chosen| &front.laws[chosen]).or(within).or(front.laws.last())
    }

    /// The verdict; `None` where no error is asked for.
    pub fn verdict(&self) -> Option<Verdict> {
        self.error.map(|_| Verdict::from_passed(self.chosen().is_some()))
    }

    /// The equation of a law, and those of the quantities in it.
    fn lines_of(&self, law: &ShortLaw) -> Vec<String> {
        let text = law.formula.to_string();
        let mut lines = vec![format!("{} = {text}", self.front.quantity.name())];
        let problem = &self.front.problem;
        let letters = law.formula.expression().map(|law| law.symbols()).unwrap_or_default();
        let used = self.front.atoms.iter().filter(|atom| letters.contains(&atom.name));
        for atom in used.filter(|atom| atom.name != problem.variable) {
            lines.extend(atom.meaning.iter().map(|meaning| format!("{} = {meaning}", atom.name)));
        }
        lines.extend(
            problem.meaning.iter().map(|meaning| format!("{} = {meaning}", problem.variable)),
        );
        lines
    }

    /// The range in words.
    pub fn range(&self) -> String {
        let problem = &self.front.problem;
        let number = |end: &Rational| decimal(to_f64(end));
        let from = number(&problem.from);
        let own = match &problem.to {
            Some(to) => format!("{from} <= {} <= {}", problem.variable, number(to)),
            None => format!("{} >= {from}", problem.variable),
        };
        match &problem.motion {
            LawMotion::Contact { restitution: Some([from, to]), .. } => {
                let e = restitution();
                format!("{} <= {e} <= {}, that is {own}", number(from), number(to))
            }
            _ => own,
        }
    }

    /// The motion in words.
    fn motion(&self) -> String {
        let problem = &self.front.problem;
        let range = self.range();
        match &problem.motion {
            LawMotion::Free { oscillator, start, solution } => {
                let amplitude = match (start, &problem.meaning) {
                    (None, _) => return format!("limit cycle, {range}"),
                    (Some(StartOfLaw::Variable), _) => problem.variable.to_string(),
                    (Some(StartOfLaw::Fixed(_)), Some(_)) => "A".to_owned(),
                    (Some(StartOfLaw::Fixed(start)), None) => start.to_string(),
                };
                let from = match solution.equilibrium.is_zero() {
                    true => amplitude,
                    false => format!("{} + {amplitude}", solution.equilibrium),
                };
                format!("released at rest from {}(0) = {from}, {range}", oscillator.coordinate)
            }
            LawMotion::Contact { .. } => format!(
                "touched with the speed v, {} the coefficient of restitution, T_0 the duration without damping, {range}",
                restitution()
            ),
            LawMotion::Mode { mode, .. } => {
                let measure = match mode.amplitude {
                    AmplitudeConvention::Initial => "the start of the first coordinate",
                    AmplitudeConvention::FirstHarmonic => "the amplitude of the first harmonic",
                };
                format!("normal mode {}, {} {measure}, {range}", mode.number, problem.variable)
            }
        }
    }
}

/// The largest error of a law in words: both proved ends, or what was measured.
fn error_in_words(law: &ShortLaw) -> String {
    match &law.proof {
        Ok((certificate, _)) => {
            let [lower, upper] = certificate.claim.each_ref().map(|end| 100.0 * to_f64(end));
            format!("between {} % and {} %, proved", significant(lower, 6), significant(upper, 6))
        }
        Err(reason) => format!("{} measured, not proved: {reason}", size_in_percent(law.error)),
    }
}

/// The document of a search.
pub fn shortest<'a>(report: &'a ShortestReport<'a>) -> Document<'a> {
    let front = report.front;
    let mut sections =
        vec![vec![Block::QuestionAsTyped(&report.equation), Block::Note(report.motion())]];
    if let Some(law) = report.shown() {
        let heading = match (report.error, report.chosen()) {
            (Some(error), chosen) => {
                let error_asked = percent(error);
                match (chosen, law.largest_error() <= error) {
                    (Some(_), _) => format!("The shortest law within {error_asked} %"),
                    (None, true) => format!("Within {error_asked} %, as far as was measured"),
                    (None, false) => {
                        format!("No law of this length is within {error_asked} %; the nearest")
                    }
                }
            }
            (None, _) => "The law with the smallest error".to_owned(),
        };
        let lines = report.lines.iter().map(|line| Block::QuestionAsTyped(line));
        let mut facts = vec![
            ("length", law.length.to_string()),
            ("largest error", error_in_words(law)),
            ("at", format!("{} = {}", front.problem.variable, decimal(law.worst))),
        ];
        facts.extend(report.verdict().map(|verdict| ("verdict", verdict.name().to_owned())));
        let heading = std::iter::once(Block::Heading(heading));
        sections.push(heading.chain(lines).chain([Block::Facts(facts)]).collect());
    }
    let rows = front.laws.iter().map(|law| {
        let how = if law.proof.is_ok() { "proved" } else { "measured" };
        let error = size_in_percent(law.largest_error());
        vec![law.formula.to_string(), law.length.to_string(), error, how.to_owned()]
    });
    let mut blocks = vec![
        Block::Heading(
            "Laws by length, each with a smaller error than all shorter ones".to_owned(),
        ),
        Block::table(["law", "length", "largest error", ""], rows),
    ];
    // One reason holds for all laws where the motion is what is not proved.
    let mut reasons: Vec<String> =
        front.laws.iter().filter_map(|law| Some(law.proof.as_ref().err()?.to_string())).collect();
    reasons.sort();
    reasons.dedup();
    blocks.extend(reasons.into_iter().map(|reason| Block::Note(format!("not proved: {reason}"))));
    sections.push(match front.laws.is_empty() {
        false => blocks,
        true => vec![Block::Note(
            "no law of this length was found: raise --longest, or ask for less at rest".to_owned(),
        )],
    });
    if !front.published.is_empty() {
        let rows = front.published.iter().map(|own| {
            let error = match own.error.is_finite() {
                true => size_in_percent(own.error),
                false => "no value".to_owned(),
            };
            let formula = format!("{} = {}", own.published.quantity.name(), own.published.text);
            vec![formula, own.length.to_string(), error, own.published.source.clone()]
        });
        sections.push(vec![
            Block::Heading("Published formulas on the same range, measured".to_owned()),
            Block::table(["formula", "length", "largest error", "source"], rows),
        ]);
    }
    sections.push(vec![Block::Note(
        "length: each digit, name, function and sign of + - * / ^ counts one; zeros in front, points and brackets nothing".to_owned(),
    )]);
    Document { sections }
}

/// The motion of a certificate of a law in words.
fn motion_of_law(certificate: &LawCertificate) -> String {
    let variable = certificate.variable;
    let (force, mass, start) = match &certificate.motions {
        MotionsOfLaw::Coordinate { force, mass, start } => (force, mass, start),
        MotionsOfLaw::Mode(branch) => {
            let rates = branch.coordinates.iter().zip(&branch.forces);
            let equation = |(name, force): (&Symbol, &Expr)| {
                let force = force.to_string();
                match force.strip_prefix('-') {
                    Some(rest) => format!("{name}'' - {rest} = 0"),
                    None => format!("{name}'' + {force} = 0"),
                }
            };
            let equations: Vec<String> = rates.map(equation).collect();
            let measure = match &branch.measure {
                ModeAmplitude::Start(coordinate) => {
                    let name = branch.coordinates.get(*coordinate);
                    format!("the start of {}", name.map_or_else(String::new, ToString::to_string))
                }
                ModeAmplitude::FirstHarmonic(_) => "the amplitude of the first harmonic".to_owned(),
            };
            let frequency = to_f64(&branch.mu).sqrt().recip();
            return format!(
                "{}, the branch of normal modes with {FREQUENCY} near {} at {variable} = {}, {variable} {measure}",
                equations.join("; "),
                significant(frequency, 6),
                certificate.from
            );
        }
    };
    let start = match start {
        StartOfLaw::Variable => variable.to_string(),
        StartOfLaw::Fixed(start) => start.to_string(),
    };
    let motion = match certificate.quantity == LawQuantity::ContactTime {
        true => format!("touched with x' = {start}, {} the restitution", restitution()),
        false => format!("from rest at x(0) = {start}"),
    };
    match mass {
        Some(mass) => {
            format!("M*x'' + (dM/dx)*x'^2/2 + f = 0, M = {mass}, f = {force}, {motion}")
        }
        None => format!("x'' + f = 0, f = {force}, {motion}"),
    }
}

/// The document of a certificate of a law that was checked.
pub fn law_certificate<'a>(certificate: &LawCertificate, error: &LawError) -> Document<'a> {
    let range = match &certificate.to {
        Some(to) => format!("{} <= {} <= {to}", certificate.from, certificate.variable),
        None => format!("{} >= {}", certificate.variable, certificate.from),
    };
    let upper = certificate.claim.each_ref().map(|end| 100.0 * to_f64(end))[1];
    let is_contact = certificate.quantity == LawQuantity::ContactTime;
    let motion = motion_of_law(certificate);
    let facts = vec![
        ("motion", motion),
        ("law", format!("{} = {}", certificate.quantity.name(), certificate.law)),
        ("range", range),
        (
            "largest error",
            format!(
                "between {} % and {} %, for every {} of the range",
                significant(100.0 * error.lower, 6),
                significant(upper, 6),
                certificate.variable
            ),
        ),
        ("at", format!("{} = {}", certificate.variable, decimal(to_f64(&certificate.worst)))),
    ];
    let question = Block::Note(match is_contact {
        true => "a law of the duration of contacts on a range".to_owned(),
        false => format!("a law of {FREQUENCY} on a range"),
    });
    Document {
        sections: vec![
            vec![question],
            vec![Block::Heading("Proved".to_owned()), Block::Facts(facts)],
        ],
    }
}

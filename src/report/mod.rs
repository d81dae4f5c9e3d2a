//! The content of a report, before any format lays it out: one file for each kind of result, which
//! makes a [`Document`] of it.
//!
//! In come results: a [`Solution`] with its [`Verification`], a
//! [`Comparison`](crate::verify::comparison::Comparison), an [`Impact`](crate::impact::Impact), a
//! [`FrictionStudy`](crate::impact::friction::FrictionStudy). Out go documents, sections of blocks;
//! every format of `export` handles each kind of block and does not depend on the results. The
//! choice of the displayed law, of omissions and of the order is made here, once.

mod absorber;
mod audit;
mod certificate;
mod comparison;
mod driven;
mod fit;
mod friction;
mod impact;
mod impact_certificate;
mod impact_comparison;
mod materials;
mod mechanism;
mod modes;
mod one_harmonic;
mod optimization;
mod orbit_certificate;
mod orbits;
mod primary;
mod response;
mod shortest;
mod slow_equations;
mod solution;
mod stability;
mod trajectory;

pub use absorber::{AbsorberReport, absorber};
pub use audit::audit;
#[cfg(feature = "json")]
pub(crate) use audit::{
    computed as audit_computed, entry as audit_entry, printed as audit_printed,
};
#[cfg(feature = "json")]
pub(crate) use certificate::known_digits;
pub use certificate::{AnyCertificate, CertificateReport, CertifiedQuestion, certificate};
pub use comparison::comparison;
pub use fit::{FitReport, FittedLaw, fit};
pub use friction::friction;
pub use impact::impact;
pub use impact_certificate::{ImpactCertificateReport, impact_certificate};
pub use impact_comparison::impact_comparison;
pub use materials::{material_sentences, materials};
pub use mechanism::{mechanism, paper_equations};
pub use modes::{ModesReport, modes};
pub use one_harmonic::{OneHarmonicReport, one_harmonic};
pub use optimization::{optimization, optimization_sentences};
pub use orbit_certificate::{OrbitCertificateReport, orbit_certificate};
pub(crate) use orbits::family_in_words;
#[cfg(feature = "json")]
pub(crate) use orbits::obstacle_in_words;
pub use orbits::{OrbitsReport, orbits};
pub use primary::{PrimaryReport, PrimarySweepReport, primary, primary_sweep};
#[cfg(feature = "json")]
pub(crate) use response::motion_frequency;
pub(crate) use response::{are_modes, has_energy, listed_quantity};
pub use response::{bifurcation_in_words, response};
pub use shortest::{ShortestReport, law_certificate, shortest};
pub use slow_equations::{SlowReport, slow_equations};
pub use solution::solution;
pub use stability::{StabilityReport, stability};
pub use trajectory::{
    BasinSweep, Doubt, MOST_STARTS, MotionSweep, TRUSTED, TrajectoryReport, basin_sweep,
    motion_sweep, trajectory,
};
pub(crate) use trajectory::{event_in_words, section_in_words, wall_in_words};

use std::borrow::Cow;

use crate::decimal::{decimal, significant};
use crate::derivation::DerivationLine;
use crate::exact::Polynomials;
use crate::expr::{Equation, Expr};
use crate::impact::contact::ContactRow;
use crate::impact::{
    FittedLine, ImpactQuantity, ImpactRow, ImpactSymbols, MotionPhase, PathSegment, PhaseReading,
    Rule,
};
use crate::series::FourierSeries;
use crate::solution::law::DisplayedLaw;
use crate::solution::{Definition, Solution, Sum};
use crate::symbol::Symbol;
use crate::values::Values;
use crate::verify::comparison::{ComparisonRow, Refused};
use crate::verify::{Verdict, Verification};

/// Sections of blocks, in the order in which they are read.
#[derive(Clone, Debug)]
pub struct Document<'a> {
    /// The sections; text leaves a line empty between them.
    pub sections: Vec<Vec<Block<'a>>>,
}

/// An element of a report.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Block<'a> {
    /// The equation of motion that the report is about.
    Question(&'a Equation),
    /// The equation as it was typed, if it has no normal form.
    QuestionAsTyped(&'a str),
    /// The method of the answer, and the definition of its amplitude.
    Title {
        /// The method and its order.
        words: String,
        /// The convention.
        amplitude: String,
    },
    /// The beginning of a section, or a sentence of its own.
    Heading(String),
    /// A note on the result.
    Note(String),
    /// A secondary note, such as a list of the other limit cycles.
    Remark(String),
    /// A sentence that follows from the numbers; it is wrapped to the width of the page.
    Sentence(String),
    /// A detail for the longest format only.
    Detail(String),
    /// A law: omega^2 or omega, or a relation between omega and the amplitude with zero on the
    /// left.
    Law {
        /// The left side.
        left: Expr,
        /// The right side.
        right: Sum,
    },
    /// An equation that is not a polynomial.
    Equality {
        /// The left side.
        left: Expr,
        /// The right side.
        right: &'a Expr,
    },
    /// A line of a derivation.
    Line(Cow<'a, DerivationLine>),
    /// The amplitude of a limit cycle.
    CycleAmplitude {
        /// Its symbol.
        symbol: Symbol,
        /// Its value.
        amplitude: Sum,
    },
    /// The motion of an answer; it is zero if only quadrature gives it.
    Motion(&'a Solution),
    /// The motion of one of several coordinates.
    Harmonics {
        /// The coordinate.
        coordinate: Symbol,
        /// Its harmonics.
        series: &'a FourierSeries<Polynomials>,
        /// The symbol by whose powers coefficients are ordered.
        amplitude: Symbol,
        /// Whether coefficients are rounded.
        rounded: bool,
        /// The name of the phase, `omega*t`.
        phase: Symbol,
    },
    /// A symbol and its definition.
    Definition(&'a Definition),
    /// A symbol and its number.
    Value {
        /// The symbol.
        name: Symbol,
        /// Its number.
        value: f64,
        /// The source of the value.
        source: Option<&'a str>,
    },
    /// The verification of a formula at given values.
    Judged {
        /// The verification.
        verification: &'a Verification,
        /// The error of the series of omega, if it is shown with that of omega^2 and differs.
        series_of_omega: Option<f64>,
        /// The name of hbar, if it was chosen by the least squared residual.
        hbar: Symbol,
    },
    /// The true frequency, which a table is compared with.
    Truth {
        /// The equation.
        equation: &'a Equation,
        /// The values.
        at: &'a Values,
        /// The frequency, or the reason why there is none.
        frequency: Result<f64, String>,
    },
    /// A table of methods.
    Methods {
        /// A row each.
        rows: Vec<MethodRow<'a>>,
        /// The values at which they are judged.
        at: &'a Values,
        /// The largest error that passes.
        tolerance: f64,
    },
    /// Names with a text for each.
    Entries {
        /// The common heading.
        heading: &'static str,
        /// The names and the words.
        entries: Vec<(String, String)>,
    },
    /// Quantities, each with its number and a remark.
    Facts(Vec<(&'static str, String)>),
    /// A table of words and numbers, these as they are to be printed; a cell may be empty.
    Table {
        /// The heading of each column.
        head: Vec<Heading>,
        /// A cell for each column.
        rows: Vec<Vec<String>>,
    },
    /// The methods that do not apply.
    Refused(&'a [Refused]),
    /// The ranges in which the true motion is periodic.
    TrueMotion(&'a [String]),
    /// The last line of a report.
    Closing(String),
    /// The phases that follow.
    Reading {
        /// The version of the phases.
        reading: PhaseReading,
        /// Its meaning, in a line.
        words: String,
    },
    /// The line that replaces the force of the barrier.
    Fitted {
        /// The line and the depth over which it was fitted.
        fitted: FittedLine,
        /// The place of the barrier.
        barrier: f64,
        /// The rule of the fit.
        rule: Rule,
        /// The letters of the equation.
        letters: ImpactSymbols,
        /// Whether the line is multiplied by the stiffness.
        per_stiffness: bool,
    },
    /// A phase of an impact.
    Phase {
        /// The phase.
        phase: &'a MotionPhase,
        /// The letters of the equation.
        letters: ImpactSymbols,
        /// The release, in words.
        release: String,
    },
    /// The phases of a chain of closed forms.
    ClosedForms(Vec<PathSegment>),
    /// The numbers of an impact compared with those of Runge-Kutta.
    Quantities {
        /// The columns.
        columns: Vec<PhaseReading>,
        /// A row each.
        rows: Vec<ImpactQuantity>,
        /// The largest deviation of each column over the amplitude, in real time.
        deviations: Vec<f64>,
        /// The largest deviation of each column in approach, contact and return, each on its own
        /// clock: of the flights over the amplitude, of the contact over the depth.
        shapes: Vec<[f64; 3]>,
    },
    /// A table of every law of a contact.
    ContactLaws {
        /// A row each.
        rows: &'a [ContactRow],
    },
    /// A table of methods on one impact.
    ImpactMethods {
        /// A row each.
        rows: &'a [ImpactRow],
        /// Time to contact, speed, penetration, duration and period of the true motion.
        truth: [f64; 5],
        /// The largest error that passes.
        tolerance: f64,
    },
    /// The verdicts on an impact.
    Verdicts {
        /// The verdict on each column.
        verdicts: Vec<(PhaseReading, Verdict)>,
        /// The largest error that passes.
        tolerance: f64,
    },
    /// A quantity in SI units: its letter, the formula that it follows from, its number.
    SiValue {
        /// The letter.
        name: &'static str,
        /// The formula, as it is typed.
        formula: Option<&'static str>,
        /// The number.
        value: f64,
        /// The unit, as it is typed.
        unit: &'static str,
        /// Its description in words.
        words: &'static str,
    },
    /// The numbers of an impact in SI units.
    SiQuantities {
        /// The columns.
        columns: Vec<PhaseReading>,
        /// A row each, with its unit as it is typed.
        rows: Vec<(ImpactQuantity, &'static str)>,
    },
}

impl Block<'_> {
    /// A table with these columns and rows.
    fn table<H: Into<Heading>>(
        head: impl IntoIterator<Item = H>,
        rows: impl IntoIterator<Item = Vec<String>>,
    ) -> Self {
        Self::Table {
            head: head.into_iter().map(Into::into).collect(),
            rows: rows.into_iter().collect(),
        }
    }
}

/// The heading of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Heading {
    /// The heading in plain text.
    pub text: &'static str,
    /// The heading in LaTeX.
    pub latex: &'static str,
}

impl From<&'static str> for Heading {
    fn from(text: &'static str) -> Self {
        Self { text, latex: text }
    }
}

impl From<(&'static str, &'static str)> for Heading {
    fn from((text, latex): (&'static str, &'static str)) -> Self {
        Self { text, latex }
    }
}

/// A signed relative error in percent: `-1.49 %`; an error of the size of rounding is named so.
///
/// ```
/// assert_eq!(lindstedt::report::percent(-0.0149), "-1.49 %");
/// ```
pub fn percent(error: f64) -> String {
    if error.abs() < 1e-9 {
        return "< 1e-7 %".to_owned();
    }
    let digits = significant(100.0 * error.abs(), 3);
    format!("{}{digits} %", if error < 0.0 { "-" } else { "+" })
}

/// An absolute value in percent: `2.86 %`; a value of the size of rounding is named so.
pub(crate) fn size_in_percent(size: f64) -> String {
    match size < 1e-9 {
        true => "< 1e-7 %".to_owned(),
        false => format!("{} %", significant(100.0 * size, 3)),
    }
}

/// A number, or a dash if there is none.
fn cell(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), decimal)
}

/// Whether the first column of a table consists of names without numbers, so that it is aligned
/// left.
pub(crate) fn are_names(rows: &[Vec<String>]) -> bool {
    let mut first = rows.iter().filter_map(|row| row.first()).peekable();
    first.peek().is_some() && first.all(|name| name.parse::<f64>().is_err())
}

/// A row of a table of methods.
#[derive(Clone, Debug)]
pub struct MethodRow<'a> {
    /// The method, its answer and its numbers.
    pub row: &'a ComparisonRow,
    /// The method and its order.
    pub title: String,
    /// Its law.
    pub law: DisplayedLaw<'a>,
    /// The definitions that the law needs.
    pub definitions: Vec<&'a Definition>,
    /// The hbar with which it was evaluated.
    pub hbar: Option<(Symbol, f64)>,
}

/// A polynomial in a variable with decimal coefficients, the lowest first.
pub(super) fn in_powers_of(variable: &str, coefficients: &[f64]) -> String {
    let mut text = String::new();
    for (power, number) in coefficients.iter().enumerate().filter(|(_, number)| **number != 0.0) {
        let sign = match (text.is_empty(), *number < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        let size = decimal(number.abs());
        text += &match power {
            0 => format!("{sign}{size}"),
            1 => format!("{sign}{size}*{variable}"),
            _ => format!("{sign}{size}*{variable}^{power}"),
        };
    }
    match text.is_empty() {
        true => "0".to_owned(),
        false => text,
    }
}

//! A claim: the text that a publication prints, and the computation that checks it.

use std::collections::BTreeMap;
use std::fmt;

use super::printed::{Printed, Rounding};
use crate::expr::Expr;
use crate::impact::Rule;
use crate::method::Options;
use crate::modes::FreeSystem;
use crate::oscillator::Oscillator;
use crate::solution::{AmplitudeConvention, Degrees, Method};
use crate::symbol::Symbol;

/// One claim of a publication.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// Its name, unique in a file.
    pub id: String,
    /// The place in the publication.
    pub place: String,
    /// The claim in words.
    pub says: String,
    /// The computation of the claimed quantity.
    pub question: ClaimComputation,
    /// The printed text: one entry, or the rows of a table.
    pub entries: Vec<PrintedEntry>,
    /// The suppositions that may be made: for each subject its alternatives, of which at most one
    /// holds.
    pub suppositions: Vec<Vec<Supposition>>,
    /// A number that the publication does not print, to be solved for.
    pub unknown: Option<Unknown>,
    /// Quantities that the publication does not print and the claim cannot be computed without, in
    /// words.
    pub needs: Vec<String>,
    /// The expected verdict; if `None`, `reproduced`.
    pub expected: Option<Verdict>,
    /// A note for the reader.
    pub note: Option<String>,
}

/// A printed entry.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintedEntry {
    /// Values of this entry alone.
    pub values: BTreeMap<Symbol, Expr>,
    /// The printed text.
    pub printed: String,
    /// The reading of an entry printed in words.
    pub read_as: Option<String>,
    /// The statement that it makes.
    pub stated: PrintedStatement,
}

/// The statement of a printed text.
#[derive(Clone, Debug, PartialEq)]
pub enum PrintedStatement {
    /// A number.
    Number(Printed),
    /// A formula.
    Formula(Expr),
    /// The order of the numbers of all entries.
    Trend(Trend),
    /// Only the words of the claim itself.
    Words,
}

/// The order of a sequence of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trend {
    /// Each is smaller than the one before: `falls`.
    Falls,
    /// Each is larger than the one before: `rises`.
    Rises,
    /// The first is the smallest: `first is least`.
    FirstIsLeast,
    /// The first is the largest: `first is greatest`.
    FirstIsGreatest,
}

impl Trend {
    /// Every trend.
    pub const ALL: [Self; 4] =
        [Self::Falls, Self::Rises, Self::FirstIsLeast, Self::FirstIsGreatest];

    /// The words in a file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Falls => "falls",
            Self::Rises => "rises",
            Self::FirstIsLeast => "first is least",
            Self::FirstIsGreatest => "first is greatest",
        }
    }

    /// The trend of these words.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|trend| trend.name() == name)
    }

    /// Whether these numbers have this order. Numbers whose relative difference is below `same`
    /// neither fall nor rise.
    pub fn holds(self, numbers: &[f64], same: f64) -> bool {
        let falls = |one: f64, other: f64| other < one - same * one.abs();
        let first = numbers.first().copied().unwrap_or(f64::NAN);
        let mut pairs = numbers.windows(2);
        let mut others = numbers.iter().skip(1);
        match self {
            Self::Falls => pairs.all(|pair| falls(pair[0], pair[1])),
            Self::Rises => pairs.all(|pair| falls(pair[1], pair[0])),
            Self::FirstIsLeast => others.all(|other| falls(*other, first)),
            Self::FirstIsGreatest => others.all(|other| falls(first, *other)),
        }
    }
}

/// The computation of a claimed quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimComputation {
    /// The quantity.
    pub quantity: ClaimQuantity,
    /// The equation of motion, for quantities that are derived from one.
    pub equation: Option<ClaimEquation>,
    /// Method, order and the like.
    pub options: Options,
    /// The rule of the line of equation (15).
    pub rule: Rule,
    /// Values of names, which may use each other.
    pub values: BTreeMap<Symbol, Expr>,
    /// The value that stands for pi.
    pub pi: Option<Expr>,
    /// The rule by which digits are cut or rounded.
    pub rounding: Rounding,
    /// The relative error that is allowed, in place of digits; for a trend, the relative difference
    /// that counts as none.
    pub tolerance: Option<f64>,
}

/// The equation of motion of a claim.
#[derive(Clone, Debug, PartialEq)]
pub enum ClaimEquation {
    /// One coordinate.
    One(Oscillator),
    /// A mode of coupled equations.
    Mode {
        /// The equations.
        system: Box<FreeSystem>,
        /// The number of the mode, 1 for the slowest.
        number: usize,
    },
}

impl ClaimEquation {
    /// The letters of the equation beside coordinates and time.
    pub fn parameters(&self) -> &[Symbol] {
        match self {
            Self::One(oscillator) => &oscillator.parameters,
            Self::Mode { system, .. } => &system.equations.parameters,
        }
    }
}

/// The quantity that is computed.
#[derive(Clone, Debug, PartialEq)]
pub enum ClaimQuantity {
    /// A number: a formula in values and in the computed quantities of [`NAMES`](super::NAMES).
    Value(Expr),
    /// The coefficient of a term in a derived law.
    Coefficient {
        /// Whether it is a coefficient of omega^2; otherwise of omega.
        squared: bool,
        /// The term, a product of powers.
        term: Expr,
    },
    /// A derived law as a whole.
    Law {
        /// Whether it is the law of omega^2; otherwise of omega.
        squared: bool,
    },
    /// The Taylor polynomial of a formula in x about zero.
    Taylor {
        /// The formula.
        formula: Expr,
        /// The highest power.
        degree: u32,
    },
    /// A formula that equals the printed one for every value of its symbols.
    Identity(Expr),
    /// The equation of motion of the coordinate x, x'' first, that follows from energies and a
    /// force.
    Motion {
        /// The kinetic energy.
        kinetic: Expr,
        /// The potential energy.
        potential: Expr,
        /// The generalised force.
        force: Expr,
    },
    /// The change of a formula from entry to entry.
    Trend(Expr),
    /// Number of coordinates of an equation: symbols with two primes.
    Coordinates(Expr),
    /// Options that must be compatible.
    Settings(Vec<(String, String)>),
    /// No quantity, because the data that it needs are not printed.
    Nothing,
}

/// A number that is not printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unknown {
    /// Its name.
    pub name: Symbol,
    /// The least and the greatest value that it may have.
    pub within: [f64; 2],
}

/// A supposition that may be made if the claim alone is not reproduced.
#[derive(Clone, Debug, PartialEq)]
pub enum Supposition {
    /// Another value of pi.
    Pi(Expr),
    /// Another rule of rounding.
    Rounding(Rounding),
    /// Another method.
    Method(Method),
    /// Another order.
    Order(u32),
    /// Degrees of an approximant.
    Degrees(Degrees),
    /// Another degree of the Taylor polynomial of the force.
    Taylor(u32),
    /// Another meaning of the amplitude.
    Amplitude(AmplitudeConvention),
    /// Another way to fit the line.
    Rule(Rule),
    /// Another reading of what is printed, and how it is typed.
    Formula(Expr, String),
    /// Values that are not printed, or others than the printed ones.
    Values(Vec<(Symbol, Expr)>),
}

impl fmt::Display for Supposition {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pi(value) => write!(formatter, "pi = {}", decimal_text(value)),
            Self::Rounding(Rounding::Rounded) => formatter.write_str("digits rounded"),
            Self::Rounding(Rounding::Cut) => formatter.write_str("digits cut off"),
            Self::Rounding(Rounding::Either) => formatter.write_str("digits rounded or cut off"),
            Self::Method(method) => write!(formatter, "method {}", method.name()),
            Self::Order(order) => write!(formatter, "order {order}"),
            Self::Degrees(degrees) => write!(formatter, "degrees {}", degrees.separated()),
            Self::Taylor(degree) => write!(formatter, "Taylor degree {degree}"),
            Self::Amplitude(convention) => write!(formatter, "amplitude {}", convention.name()),
            Self::Rule(rule) => write!(formatter, "line by {rule}"),
            Self::Formula(_, typed) => write!(formatter, "read as {typed}"),
            Self::Values(values) => {
                let each: Vec<String> = values
                    .iter()
                    .map(|(name, value)| format!("{name} = {}", decimal_text(value)))
                    .collect();
                formatter.write_str(&each.join(", "))
            }
        }
    }
}

/// A value as it was probably typed: as a decimal if its denominator has only the factors two and
/// five.
fn decimal_text(value: &Expr) -> String {
    let Some(number) = value.as_number() else {
        return value.to_string();
    };
    let text = crate::decimal::significant_fraction(number, 12);
    let again = crate::expr::parse_expression(&text);
    match again.is_ok_and(|again| again.as_number() == Some(number)) {
        true => text,
        false => value.to_string(),
    }
}

impl ClaimComputation {
    /// The computation with these suppositions.
    pub(super) fn supposing(&self, suppositions: &[&Supposition]) -> Self {
        let mut question = self.clone();
        for supposition in suppositions {
            match supposition {
                Supposition::Pi(value) => question.pi = Some(value.clone()),
                Supposition::Rounding(rounding) => question.rounding = *rounding,
                Supposition::Method(method) => question.options.method = Some(*method),
                Supposition::Order(order) => question.options.order = Some(*order),
                Supposition::Degrees(degrees) => question.options.degrees = Some(*degrees),
                Supposition::Taylor(degree) => question.options.taylor = Some(*degree),
                Supposition::Amplitude(convention) => {
                    question.options.amplitude = Some(*convention)
                }
                Supposition::Rule(rule) => question.rule = *rule,
                Supposition::Formula(formula, _) => question.quantity.read_as(formula),
                Supposition::Values(values) => question.values.extend(values.iter().cloned()),
            }
        }
        question
    }
}

impl ClaimQuantity {
    fn read_as(&mut self, other: &Expr) {
        match self {
            Self::Value(formula)
            | Self::Taylor { formula, .. }
            | Self::Identity(formula)
            | Self::Trend(formula)
            | Self::Coordinates(formula) => *formula = other.clone(),
            Self::Coefficient { .. }
            | Self::Law { .. }
            | Self::Motion { .. }
            | Self::Settings(_)
            | Self::Nothing => {}
        }
    }
}

/// The verdict on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The claim is reproduced to every printed digit.
    Reproduced,
    /// The claim is reproduced to every printed digit under an assumption that the publication does
    /// not state and the program found.
    UnderAssumption,
    /// A quantity that is needed is not printed.
    NotReproducible,
    /// The computed value differs.
    Inconsistent,
}

impl Verdict {
    /// Every verdict, the best first.
    pub const ALL: [Self; 4] =
        [Self::Reproduced, Self::UnderAssumption, Self::NotReproducible, Self::Inconsistent];

    /// The name in files and documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::UnderAssumption => "reproduced-under-assumption",
            Self::NotReproducible => "not-reproducible",
            Self::Inconsistent => "inconsistent",
        }
    }

    /// The verdict of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|verdict| verdict.name() == name)
    }

    /// Whether the printed text is reproduced, with or without an assumption.
    pub fn is_reproduced(self) -> bool {
        matches!(self, Self::Reproduced | Self::UnderAssumption)
    }
}

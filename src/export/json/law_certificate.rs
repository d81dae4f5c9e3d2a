//! Kind `certificate`, of a law on a range: how far a frequency law is off at most, to be proved again.

use num_traits::Signed as _;
#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::mode_certificate::{read_coordinates, short_expression};
use super::number::texts;
use super::schema::check_kind;
use super::{DocumentKind, JsonError, unexpected};
use crate::certificate::{
    LawCertificate, LawQuantity, ModeAmplitude, ModeBranch, MotionsOfLaw, StartOfLaw,
};
use crate::decimal::exact_decimal;
use crate::exact::Rational;
use crate::expr::parse_expression;
use crate::symbol::Symbol;

/// The forms of the equation in `ode`: of a free motion, with a mass m that depends on the position, of a
/// contact, of a mode `q = a v` with `mu = 1/omega^2`.
pub const EQUATIONS_ON_A_RANGE: [&str; 4] =
    ["x''+f(x,p)=0", "m*x''+(dm/dx)*x'^2/2+f(x,p)=0", "x''+f(x,x')=0", "a*v''+mu*f(a*v)=0"];

/// The start where the variable is the amplitude, or the speed at the touch.
const VARIABLE: &str = "variable";

/// A number has at most so many characters.
const LONGEST_NUMBER: usize = 200;

/// A frequency law of `x'' + f(x; p) = 0` on a range of the amplitude or of a parameter, a law of the
/// duration of contacts, or one of a nonlinear normal mode on a range of its amplitude, and how far it is off. All numbers are text: integers, fractions such as `14/5`, decimals such as `0.0011`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LawCertificateDocument {
    /// The kind of document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = DocumentKind::Certificate.schema())))]
    pub schema: String,
    /// The equation that f belongs to.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = EQUATIONS_ON_A_RANGE)))]
    pub ode: String,
    /// The force, an expression in x, zero at x = 0, and in the variable where that is a parameter; of a
    /// contact `x^n*(1 + c*x')` with numbers. Null for a mode.
    pub f: Option<String>,
    /// The mass m, an expression as f is; null where it is one.
    #[serde(default)]
    pub mass: Option<String>,
    /// The mode; null for motions of one coordinate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mode: Option<ModeOfLawDocument>,
    /// The name of the variable.
    pub variable: String,
    /// x(0), with x'(0) = 0: `variable` where the variable is the amplitude, else a positive number; of a
    /// contact x'(0), and of a mode its amplitude, `variable`.
    pub start: String,
    /// The quantity of the law: `omega`, `omega^2`, `T/(2*pi)`, or `T/T_0`, the duration of a contact over
    /// that without damping.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["omega", "omega^2", "T/(2*pi)", "T/T_0"])))]
    pub quantity: String,
    /// The law, an expression in the variable; of a contact in its restitution e as well.
    pub law: String,
    /// The lower end of the range, not negative.
    pub from: String,
    /// The upper end; null for infinity.
    pub to: Option<String>,
    /// A value of the variable at which the error is at least the first of `error`.
    pub worst: String,
    /// The largest `|law/truth - 1|` on the range is at least and at most this.
    pub error: [String; 2],
}

/// The motions of a nonlinear normal mode, `q'' + f(q) = 0` with `q = a v(omega t)`, on a range of its
/// amplitude a. Every velocity is zero at t = 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ModeOfLawDocument {
    /// The names of the coordinates.
    pub coordinates: Vec<String>,
    /// The acceleration of each coordinate with its sign changed, an expression in the coordinates:
    /// the mass matrix is inverted already.
    pub f: Vec<String>,
    /// The name of the coordinate whose start the amplitude is; null where it is that of the first harmonic.
    pub start_of: Option<String>,
    /// The factor of each coordinate in the sum whose first harmonic has the amplitude, an
    /// expression of numbers; null where it is the start of a coordinate.
    pub first_harmonic_of: Option<Vec<String>>,
    /// 1/omega^2 at the lower end of the range, to some digits: with `c` it tells which mode it is.
    pub mu: String,
    /// The cosine coefficients of v of each coordinate there, that of the constant first: of the motion of the
    /// law mu and c differ from these by less than 2^-20 in all.
    pub c: Vec<Vec<String>>,
}

/// The form of the equation for a quantity, with a mass that depends on the position or without, of a mode or
/// of one coordinate.
const fn equation(quantity: LawQuantity, has_mass: bool, is_mode: bool) -> &'static str {
    match (is_mode, quantity, has_mass) {
        (true, ..) => EQUATIONS_ON_A_RANGE[3],
        (false, LawQuantity::ContactTime, _) => EQUATIONS_ON_A_RANGE[2],
        (false, _, true) => EQUATIONS_ON_A_RANGE[1],
        (false, _, false) => EQUATIONS_ON_A_RANGE[0],
    }
}

/// A number as a decimal, or as a fraction where it is none.
fn number_text(number: &Rational) -> String {
    exact_decimal(number).unwrap_or_else(|| number.to_string())
}

/// The document of a certificate.
pub fn law_certificate(certificate: &LawCertificate) -> LawCertificateDocument {
    let variable = || VARIABLE.to_owned();
    let (f, mass, mode, start) = match &certificate.motions {
        MotionsOfLaw::Coordinate { force, mass, start } => {
            let start = match start {
                StartOfLaw::Variable => variable(),
                StartOfLaw::Fixed(start) => start.to_string(),
            };
            (Some(force.to_string()), mass.as_ref().map(ToString::to_string), None, start)
        }
        MotionsOfLaw::Mode(branch) => (None, None, Some(mode_of_law(branch)), variable()),
    };
    LawCertificateDocument {
        schema: DocumentKind::Certificate.schema().to_owned(),
        ode: equation(certificate.quantity, mass.is_some(), mode.is_some()).to_owned(),
        f,
        mass,
        mode,
        variable: certificate.variable.name().to_owned(),
        start,
        quantity: certificate.quantity.name().to_owned(),
        law: certificate.law.to_string(),
        from: certificate.from.to_string(),
        to: certificate.to.as_ref().map(Rational::to_string),
        worst: certificate.worst.to_string(),
        error: certificate.claim.each_ref().map(number_text),
    }
}

fn mode_of_law(branch: &ModeBranch) -> ModeOfLawDocument {
    let (start_of, first_harmonic_of) = match &branch.measure {
        ModeAmplitude::Start(coordinate) => {
            (branch.coordinates.get(*coordinate).map(ToString::to_string), None)
        }
        ModeAmplitude::FirstHarmonic(factors) => (None, Some(texts(factors))),
    };
    let list = |list: &Vec<Rational>| list.iter().map(number_text).collect();
    ModeOfLawDocument {
        coordinates: texts(&branch.coordinates),
        f: texts(&branch.forces),
        start_of,
        first_harmonic_of,
        mu: number_text(&branch.mu),
        c: branch.coefficients.iter().map(list).collect(),
    }
}

/// A number of a certificate.
fn number(key: &str, text: &str) -> Result<Rational, JsonError> {
    let value = (text.len() <= LONGEST_NUMBER).then(|| parse_expression(text).ok()).flatten();
    let value = value.and_then(|value| value.as_number().cloned());
    value.map_or_else(|| unexpected(key, "a number"), Ok)
}

impl ModeOfLawDocument {
    fn read(&self) -> Result<ModeBranch, JsonError> {
        let coordinates = read_coordinates(&self.coordinates)?;
        let expressions = |texts: &[String], key: &str| {
            texts.iter().map(|text| short_expression(text, key)).collect::<Result<Vec<_>, _>>()
        };
        let measure = match (&self.start_of, &self.first_harmonic_of) {
            (Some(name), None) => {
                let place = self.coordinates.iter().position(|own| own == name);
                let place = place.map_or_else(|| unexpected("start_of", "a coordinate"), Ok)?;
                ModeAmplitude::Start(place)
            }
            (None, Some(factors)) => {
                ModeAmplitude::FirstHarmonic(expressions(factors, "first_harmonic_of")?)
            }
            _ => return unexpected("mode", "either `start_of` or `first_harmonic_of`"),
        };
        let list = |list: &Vec<String>| list.iter().map(|text| number("c", text)).collect();
        Ok(ModeBranch {
            coordinates,
            forces: expressions(&self.f, "f")?,
            measure,
            mu: number("mu", &self.mu)?,
            coefficients: self.c.iter().map(list).collect::<Result<_, _>>()?,
        })
    }
}

impl LawCertificateDocument {
    /// The certificate.
    ///
    /// # Errors
    /// A key that holds what it never holds.
    pub fn read(&self) -> Result<LawCertificate, JsonError> {
        check_kind(&self.schema, DocumentKind::Certificate)?;
        let is_name = |letter: char| letter.is_alphanumeric() || letter == '_';
        let begins = self.variable.starts_with(char::is_alphabetic);
        if !begins || !self.variable.chars().all(is_name) || self.variable.len() > LONGEST_NUMBER {
            return unexpected("variable", "a name");
        }
        let quantity = LawQuantity::ALL.into_iter().find(|own| own.name() == self.quantity);
        let Some(quantity) = quantity else {
            return unexpected("quantity", "`omega`, `omega^2`, `T/(2*pi)` or `T/T_0`");
        };
        let form = equation(quantity, self.mass.is_some(), self.mode.is_some());
        if self.ode != form {
            return unexpected("ode", form);
        }
        let [lower, upper] = &self.error;
        let claim = [number("error", lower)?, number("error", upper)?];
        if claim.iter().any(Rational::is_negative) {
            return unexpected("error", "numbers that are not negative");
        }
        let start = match self.start.as_str() {
            VARIABLE => StartOfLaw::Variable,
            start => StartOfLaw::Fixed(number("start", start)?),
        };
        let motions = match (&self.f, &self.mode) {
            (Some(force), None) => {
                let mass = self.mass.as_deref().map(|mass| short_expression(mass, "mass"));
                let force = short_expression(force, "f")?;
                MotionsOfLaw::Coordinate { force, mass: mass.transpose()?, start }
            }
            (None, Some(mode)) if start == StartOfLaw::Variable && self.mass.is_none() => {
                MotionsOfLaw::Mode(mode.read()?)
            }
            _ => return unexpected("f", "a force, or null beside a mode without a mass"),
        };
        Ok(LawCertificate {
            motions,
            variable: Symbol::new(&self.variable),
            quantity,
            law: short_expression(&self.law, "law")?,
            from: number("from", &self.from)?,
            to: self.to.as_deref().map(|to| number("to", to)).transpose()?,
            worst: number("worst", &self.worst)?,
            claim,
        })
    }
}

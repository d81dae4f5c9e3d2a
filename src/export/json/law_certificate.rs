//! Kind `certificate`, of a law on a range: how far a frequency law is off at most, to be proved again.

use num_traits::Signed as _;
#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::certificate::LONGEST_FORCE;
use super::number::expression;
use super::schema::check_kind;
use super::{DocumentKind, JsonError, unexpected};
use crate::certificate::{LawCertificate, LawQuantity, StartOfLaw};
use crate::decimal::exact_decimal;
use crate::exact::Rational;
use crate::expr::parse_expression;
use crate::symbol::Symbol;

/// The forms of the equation in `ode`: of a free motion, with a mass m that depends on the position, of a
/// contact.
pub const EQUATIONS_ON_A_RANGE: [&str; 3] =
    ["x''+f(x,p)=0", "m*x''+(dm/dx)*x'^2/2+f(x,p)=0", "x''+f(x,x')=0"];

/// The start where the variable is the amplitude, or the speed at the touch.
const VARIABLE: &str = "variable";

/// A number has at most so many characters.
const LONGEST_NUMBER: usize = 200;

/// A frequency law of `x'' + f(x; p) = 0` on a range of the amplitude or of a parameter, or a law of the
/// duration of contacts, and how far it is off. All numbers are text: integers, fractions such as `14/5`, decimals such as `0.0011`.
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
    /// contact `x^n*(1 + c*x')` with numbers.
    pub f: String,
    /// The mass m, an expression as f is; null where it is one.
    #[serde(default)]
    pub mass: Option<String>,
    /// The name of the variable.
    pub variable: String,
    /// x(0), with x'(0) = 0: `variable` where the variable is the amplitude, else a positive number; of a
    /// contact x'(0), `variable`.
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

/// The form of the equation for a quantity, with a mass that depends on the position or without.
const fn equation(quantity: LawQuantity, has_mass: bool) -> &'static str {
    match (quantity, has_mass) {
        (LawQuantity::ContactTime, _) => EQUATIONS_ON_A_RANGE[2],
        (_, true) => EQUATIONS_ON_A_RANGE[1],
        (_, false) => EQUATIONS_ON_A_RANGE[0],
    }
}

/// The document of a certificate.
pub fn law_certificate(certificate: &LawCertificate) -> LawCertificateDocument {
    let error = certificate.claim.each_ref();
    LawCertificateDocument {
        schema: DocumentKind::Certificate.schema().to_owned(),
        ode: equation(certificate.quantity, certificate.mass.is_some()).to_owned(),
        f: certificate.force.to_string(),
        mass: certificate.mass.as_ref().map(ToString::to_string),
        variable: certificate.variable.name().to_owned(),
        start: match &certificate.start {
            StartOfLaw::Variable => VARIABLE.to_owned(),
            StartOfLaw::Fixed(start) => start.to_string(),
        },
        quantity: certificate.quantity.name().to_owned(),
        law: certificate.law.to_string(),
        from: certificate.from.to_string(),
        to: certificate.to.as_ref().map(Rational::to_string),
        worst: certificate.worst.to_string(),
        error: error.map(|number| exact_decimal(number).unwrap_or_else(|| number.to_string())),
    }
}

impl LawCertificateDocument {
    /// The certificate.
    ///
    /// # Errors
    /// A key that holds what it never holds.
    pub fn read(&self) -> Result<LawCertificate, JsonError> {
        check_kind(&self.schema, DocumentKind::Certificate)?;
        let number = |key: &str, text: &str| -> Result<Rational, JsonError> {
            let value =
                (text.len() <= LONGEST_NUMBER).then(|| parse_expression(text).ok()).flatten();
            let value = value.and_then(|value| value.as_number().cloned());
            value.map_or_else(|| unexpected(key, "a number"), Ok)
        };
        let formula = |key: &str, text: &str| match text.len() <= LONGEST_FORCE {
            true => expression(text, key),
            false => unexpected(key, "an expression of at most 2000 characters"),
        };
        let is_name = |letter: char| letter.is_alphanumeric() || letter == '_';
        let begins = self.variable.starts_with(char::is_alphabetic);
        if !begins || !self.variable.chars().all(is_name) || self.variable.len() > LONGEST_NUMBER {
            return unexpected("variable", "a name");
        }
        let quantity = LawQuantity::ALL.into_iter().find(|own| own.name() == self.quantity);
        let Some(quantity) = quantity else {
            return unexpected("quantity", "`omega`, `omega^2`, `T/(2*pi)` or `T/T_0`");
        };
        let form = equation(quantity, self.mass.is_some());
        if self.ode != form {
            return unexpected("ode", form);
        }
        let [lower, upper] = &self.error;
        let claim = [number("error", lower)?, number("error", upper)?];
        if claim.iter().any(Rational::is_negative) {
            return unexpected("error", "numbers that are not negative");
        }
        Ok(LawCertificate {
            force: formula("f", &self.f)?,
            mass: self.mass.as_deref().map(|mass| formula("mass", mass)).transpose()?,
            variable: Symbol::new(&self.variable),
            start: match self.start.as_str() {
                VARIABLE => StartOfLaw::Variable,
                start => StartOfLaw::Fixed(number("start", start)?),
            },
            quantity,
            law: formula("law", &self.law)?,
            from: number("from", &self.from)?,
            to: self.to.as_deref().map(|to| number("to", to)).transpose()?,
            worst: number("worst", &self.worst)?,
            claim,
        })
    }
}

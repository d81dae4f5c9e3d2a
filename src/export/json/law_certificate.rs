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

/// The form of the equation in `ode`.
pub const EQUATION_ON_A_RANGE: &str = "x''+f(x,p)=0";

/// The start where the variable is the amplitude.
const VARIABLE: &str = "variable";

/// A number has at most so many characters.
const LONGEST_NUMBER: usize = 200;

/// A frequency law of `x'' + f(x; p) = 0` on a range of the amplitude or of a parameter, and how far it
/// is off. All numbers are text: integers, fractions such as `14/5`, decimals such as `0.0011`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LawCertificateDocument {
    /// The kind of document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = DocumentKind::Certificate.schema())))]
    pub schema: String,
    /// The equation that f belongs to.
    #[cfg_attr(feature = "schema", schemars(extend("const" = EQUATION_ON_A_RANGE)))]
    pub ode: String,
    /// The force, an expression in x, zero at x = 0, and in the variable where that is a parameter.
    pub f: String,
    /// The name of the variable.
    pub variable: String,
    /// x(0), with x'(0) = 0: `variable` where the variable is the amplitude, else a positive number.
    pub start: String,
    /// The quantity of the law: `omega`, `omega^2` or `T/(2*pi)`.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["omega", "omega^2", "T/(2*pi)"])))]
    pub quantity: String,
    /// The law, an expression in the variable.
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

/// The document of a certificate.
pub fn law_certificate(certificate: &LawCertificate) -> LawCertificateDocument {
    let error = certificate.claim.each_ref();
    LawCertificateDocument {
        schema: DocumentKind::Certificate.schema().to_owned(),
        ode: EQUATION_ON_A_RANGE.to_owned(),
        f: certificate.force.to_string(),
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
        if self.ode != EQUATION_ON_A_RANGE {
            return unexpected("ode", EQUATION_ON_A_RANGE);
        }
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
        let quantities =
            [LawQuantity::Frequency, LawQuantity::FrequencySquared, LawQuantity::Period];
        let quantity = quantities.into_iter().find(|own| own.name() == self.quantity);
        let Some(quantity) = quantity else {
            return unexpected("quantity", "`omega`, `omega^2` or `T/(2*pi)`");
        };
        let [lower, upper] = &self.error;
        let claim = [number("error", lower)?, number("error", upper)?];
        if claim.iter().any(Rational::is_negative) {
            return unexpected("error", "numbers that are not negative");
        }
        Ok(LawCertificate {
            force: formula("f", &self.f)?,
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

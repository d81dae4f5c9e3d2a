//! Kind `certificate`, of a free motion of several coordinates: numbers from which it, and the error
//! of the formulas of a mode, can be proved.
//!
//! Every number is text, as in the certificate of one coordinate, from which it is told by `ode`.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::certificate::{
    CertificateLetters, LONGEST_FORCE, check_sizes, claim, claims, decimal, fraction, integer,
    integers, letters, matrix, range, read_letters, read_values, values,
};
use super::number::{expression, texts};
use super::schema::check_kind;
use super::{DocumentKind, JsonError, unexpected};
use crate::certificate::{JudgedFormula, ModeAmplitude, ModeCertificate};
use crate::exact::{Integer, Rational};
use crate::expr::Expr;
use crate::symbol::Symbol;

/// The form of the equations in `ode` of a certificate of several coordinates.
pub const EQUATIONS_OF_MODES: &str = "q''+f(q)=0";

/// The largest number of coordinates that is read.
pub(super) const MOST_COORDINATES: usize = 40;

/// Numbers from which a free motion of several coordinates, `q'' + f(q) = 0`, can be proved, and how
/// far the formulas of a normal mode are off. All numbers are text: integers, fractions such as
/// `-1/6`, decimals such as `2.5e-33`. Every velocity is zero at t = 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ModeCertificateDocument {
    /// The kind of document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = DocumentKind::Certificate.schema())))]
    pub schema: String,
    /// The equations that f belongs to.
    #[cfg_attr(feature = "schema", schemars(extend("const" = EQUATIONS_OF_MODES)))]
    pub ode: String,
    /// The names of the coordinates.
    pub coordinates: Vec<String>,
    /// The acceleration of each coordinate with its sign changed, an expression in the coordinates:
    /// the mass matrix is inverted already.
    pub f: Vec<String>,
    /// The amplitude of the motion.
    pub amplitude: CertificateAmplitude,
    /// Whether every f is odd and the motion of odd harmonics alone, and so the block, and the only
    /// one within claim_r among those.
    pub odd: bool,
    /// `mu`, `c` and the numbers of the formula are integers times 2^-bits; at most 224.
    pub bits: usize,
    /// The approximate 1/omega^2.
    pub mu: String,
    /// The approximate cosine coefficients of each coordinate, that of the constant first.
    pub c: Vec<Vec<String>>,
    /// The last harmonic of the block; at most 400, and the block has at most 401 unknowns.
    pub highest_harmonic: usize,
    /// The entries of `inverse` are integers times 2^-inverse_bits; at most 224.
    pub inverse_bits: usize,
    /// The approximate inverse of the derivative on mu and the harmonics of the block, those of one
    /// coordinate after those of the other, row by row; the first row is that of mu, the first
    /// column that of the condition on the amplitude.
    pub inverse: Vec<Vec<String>>,
    /// The norm is sigma |mu| + sum |c_ik|, sigma = 2^sigma_log2.
    pub sigma_log2: i32,
    /// The weight of a harmonic from one to the next; 1.
    #[cfg_attr(feature = "schema", schemars(extend("const" = "1")))]
    pub nu: String,
    /// The radius that is claimed: there is exactly one motion of this amplitude whose mu and c are
    /// so near in the norm, where `odd` exactly one of odd harmonics.
    pub claim_r: String,
    /// The formulas that are judged; null where none are.
    pub formula: Option<CertificateFormulaOfMode>,
}

/// The amplitude of a motion of several coordinates: the start of one of them, or the amplitude of
/// the first harmonic of a sum of all.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CertificateAmplitude {
    /// Its value, a fraction, exact.
    pub value: String,
    /// The name of the coordinate whose start it is; null where it is that of the first harmonic.
    pub start_of: Option<String>,
    /// The factor of each coordinate in the sum whose first harmonic has the amplitude, an
    /// expression of numbers; null where it is the start of a coordinate.
    pub first_harmonic_of: Option<Vec<String>>,
}

/// The formulas of a mode with their numbers, and what is proved of them, each from below and from
/// above.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CertificateFormulaOfMode {
    /// The law as it was derived: `omega^2 = ...` with definitions of letters behind commas, which
    /// has to give `omega` at `values` to its last digits. What is of another form is words: nothing
    /// is checked against them.
    pub law: String,
    /// The letters of the answer in the law.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub letters: Option<CertificateLetters>,
    /// The values of the letters in the law, such as `a = 4/5`.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub values: String,
    /// omega~, an integer times 2^-bits.
    pub omega: String,
    /// The cosine coefficients of each coordinate, likewise.
    pub c: Vec<Vec<String>>,
    /// max |X - X~|, both at the same phase, the largest of those of the coordinates.
    pub phase_error: [String; 2],
    /// |omega - omega~|.
    pub frequency_error: [String; 2],
    /// max |X~'| |omega - omega~|, the largest of those of the coordinates: |q(t) - q~(t)| <=
    /// phase_error + drift |t| for all t and every coordinate q.
    pub drift: [String; 2],
}

/// The document of kind `certificate` of a motion of several coordinates.
///
/// ```
/// use lindstedt::certificate::certify_mode;
/// use lindstedt::modes::{FreeSystem, ModeOptions, derive};
///
/// let pair = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0")?;
/// let modes = derive(&pair, &ModeOptions { mode: Some(1), ..ModeOptions::default() })?;
/// let mode = modes.modes[0].as_ref().expect("no resonance");
/// let (certificate, _) = certify_mode(&modes.system, mode, &"a = 4/5".parse()?)?;
/// let document = lindstedt::export::json::mode_certificate(&certificate);
/// assert_eq!(document.f, ["2*x - y + x^3/2", "-x + 2*y"]);
/// assert_eq!(document.read()?, certificate);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn mode_certificate(certificate: &ModeCertificate) -> ModeCertificateDocument {
    let (start_of, first_harmonic_of) = match &certificate.measure {
        ModeAmplitude::Start(coordinate) => {
            (certificate.coordinates.get(*coordinate).map(ToString::to_string), None)
        }
        ModeAmplitude::FirstHarmonic(factors) => (None, Some(texts(factors))),
    };
    let lists = |lists: &[Vec<Integer>]| lists.iter().map(texts).collect();
    ModeCertificateDocument {
        schema: DocumentKind::Certificate.schema().to_owned(),
        ode: EQUATIONS_OF_MODES.to_owned(),
        coordinates: texts(&certificate.coordinates),
        f: texts(&certificate.forces),
        amplitude: CertificateAmplitude {
            value: certificate.amplitude.to_string(),
            start_of,
            first_harmonic_of,
        },
        odd: certificate.odd,
        bits: certificate.bits,
        mu: certificate.mu.to_string(),
        c: lists(&certificate.coefficients),
        highest_harmonic: certificate.highest,
        inverse_bits: certificate.inverse_bits,
        inverse: lists(&certificate.inverse),
        sigma_log2: certificate.sigma,
        nu: "1".to_owned(),
        claim_r: claim(&certificate.claim),
        formula: certificate.formula.as_ref().map(|formula| CertificateFormulaOfMode {
            law: formula.law.clone(),
            letters: letters(formula.letters),
            values: values(&formula.values),
            omega: formula.frequency.to_string(),
            c: std::iter::once(&formula.coefficients).chain(&formula.others).map(texts).collect(),
            phase_error: claims(&formula.deviation),
            frequency_error: claims(&formula.frequency_error),
            drift: claims(&formula.drift),
        }),
    }
}

/// An expression of a certain length at most.
pub(super) fn short_expression(text: &str, key: &str) -> Result<Expr, JsonError> {
    match text.len() > LONGEST_FORCE {
        true => unexpected(key, "an expression of at most 2000 characters"),
        false => expression(text, key),
    }
}

/// The names of coordinates as symbols.
pub(super) fn read_coordinates(names: &[String]) -> Result<Vec<Symbol>, JsonError> {
    let read = |name: &String| {
        let letter = short_expression(name, "coordinates")?.as_symbol();
        let plain = letter.filter(|letter| letter.primes() == 0 && letter.name() != "t");
        plain.map_or_else(|| unexpected("coordinates", "names, such as x"), Ok)
    };
    names.iter().map(read).collect()
}

impl CertificateFormulaOfMode {
    fn read(&self) -> Result<JudgedFormula, JsonError> {
        let mut lists = self.c.iter().map(|list| integers(list, "formula.c"));
        Ok(JudgedFormula {
            law: self.law.clone(),
            letters: read_letters(self.letters.as_ref())?,
            values: read_values(&self.values)?,
            frequency: integer(&self.omega, "omega")?,
            coefficients: lists.next().transpose()?.unwrap_or_default(),
            others: lists.collect::<Result<_, _>>()?,
            sines: vec![],
            deviation: range(&self.phase_error, "phase_error")?,
            frequency_error: range(&self.frequency_error, "frequency_error")?,
            drift: range(&self.drift, "drift")?,
            amplitude_error: <[Rational; 2]>::default(),
        })
    }
}

impl ModeCertificateDocument {
    /// The certificate that is written, with nothing checked but that it is one.
    ///
    /// # Errors
    /// A key that holds something else, or more than a certificate ever has.
    pub fn read(&self) -> Result<ModeCertificate, JsonError> {
        check_kind(&self.schema, DocumentKind::Certificate)?;
        if self.ode != EQUATIONS_OF_MODES {
            return unexpected("ode", "`q''+f(q)=0`");
        }
        check_sizes(
            &self.nu,
            self.highest_harmonic,
            &self.inverse,
            [self.bits, self.inverse_bits],
        )?;
        let of_formula = self.formula.as_ref().map_or(0, |formula| formula.c.len());
        let counts = [self.coordinates.len(), self.f.len(), self.c.len(), of_formula];
        if counts.iter().any(|count| *count > MOST_COORDINATES) {
            return unexpected("coordinates", "at most 40 names");
        }
        let coordinates = read_coordinates(&self.coordinates)?;
        let amplitude = &self.amplitude;
        let measure = match (&amplitude.start_of, &amplitude.first_harmonic_of) {
            (Some(name), None) => {
                let place = self.coordinates.iter().position(|known| known == name);
                let unknown = || unexpected("start_of", "the name of a coordinate");
                ModeAmplitude::Start(place.map_or_else(unknown, Ok)?)
            }
            (None, Some(factors)) if factors.len() <= MOST_COORDINATES => {
                let factors = factors.iter();
                let factors = factors.map(|text| short_expression(text, "first_harmonic_of"));
                ModeAmplitude::FirstHarmonic(factors.collect::<Result<_, _>>()?)
            }
            _ => return unexpected("amplitude", "`start_of` or `first_harmonic_of`"),
        };
        Ok(ModeCertificate {
            forces: self
                .f
                .iter()
                .map(|text| short_expression(text, "f"))
                .collect::<Result<_, _>>()?,
            coordinates,
            measure,
            amplitude: fraction(&amplitude.value, "amplitude")?,
            odd: self.odd,
            bits: self.bits,
            mu: integer(&self.mu, "mu")?,
            coefficients: self
                .c
                .iter()
                .map(|list| integers(list, "c"))
                .collect::<Result<_, _>>()?,
            highest: self.highest_harmonic,
            inverse_bits: self.inverse_bits,
            inverse: matrix(&self.inverse)?,
            sigma: self.sigma_log2,
            claim: decimal(&self.claim_r, "claim_r")?,
            formula: self.formula.as_ref().map(CertificateFormulaOfMode::read).transpose()?,
        })
    }
}

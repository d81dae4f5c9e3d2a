//! Kind `certificate`: numbers from which a motion, and the error of a formula, can be proved.
//!
//! The keys say what they hold in words; the letters of the theorem that some of them once had, `A`,
//! `K`, `Abits` and `A_block`, are read as well.
//!
//! Every number is text, an integer or a fraction: a program with whole numbers of any length
//! checks a certificate without a single rounded operation. A reader treats what it reads as
//! hostile, and so does [`CertificateDocument::read`].

use num_traits::Zero as _;
#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number::{expression, texts};
use super::schema::check_kind;
use super::{DocumentKind, JsonError, unexpected};
use crate::certificate::{
    Certificate, ClaimedStability, HIGHEST_HARMONIC, JudgedFormula, LettersOfLaw, MOST_BITS,
    coordinate,
};
use crate::decimal::{exact_decimal, neighbours, significant_fraction};
use crate::exact::{Integer, Rational};
use crate::expr::Expr;
use crate::values::Values;

/// A number has at most so many characters.
const LONGEST_NUMBER: usize = 200;

/// The values of letters have at most so many: that of a double as a fraction has some hundreds.
const LONGEST_VALUES: usize = 10_000;

/// A force has at most so many.
pub(super) const LONGEST_FORCE: usize = 2000;

/// Numbers from which a motion of `x'' + f(x) = 0` can be proved, and how far a formula for it is
/// off. All numbers are text: integers, fractions such as `-1/6`, decimals such as `2.5e-33`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CertificateDocument {
    /// The kind of document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = DocumentKind::Certificate.schema())))]
    pub schema: String,
    /// The equation that f belongs to.
    #[cfg_attr(feature = "schema", schemars(extend("const" = EQUATION)))]
    pub ode: String,
    /// The force: the coefficients of a polynomial by rising power of x, or an expression in x.
    pub f: CertificateForce,
    /// x(0), a fraction, exact; x'(0) = 0.
    #[serde(alias = "A")]
    pub initial_displacement: String,
    /// Whether f is odd: then the motion has odd harmonics alone, and so has the block.
    pub odd: bool,
    /// `mu`, `c` and the numbers of the formula are integers times 2^-bits; at most 224.
    pub bits: usize,
    /// The approximate 1/omega^2.
    pub mu: String,
    /// The approximate cosine coefficients c_0, c_1, ... of the motion.
    pub c: Vec<String>,
    /// The last harmonic of the block; at most 400.
    #[serde(alias = "K")]
    pub highest_harmonic: usize,
    /// The entries of `inverse` are integers times 2^-inverse_bits; at most 224.
    #[serde(alias = "Abits")]
    pub inverse_bits: usize,
    /// The approximate inverse of the derivative on mu and the c_k of the block, row by row; the
    /// first row is that of mu, the first column that of the condition x(0) = initial_displacement.
    #[serde(alias = "A_block")]
    pub inverse: Vec<Vec<String>>,
    /// The norm is sigma |mu| + sum |c_k|, sigma = 2^sigma_log2.
    pub sigma_log2: i32,
    /// The weight of a harmonic from one to the next; 1.
    #[cfg_attr(feature = "schema", schemars(extend("const" = "1")))]
    pub nu: String,
    /// The radius that is claimed: the true mu and c are so near in the norm.
    pub claim_r: String,
    /// The formula that is judged; null where none is.
    pub formula: Option<CertificateFormula>,
}

/// The form of the equation in `ode`.
const EQUATION: &str = "x''+f(x)=0";

/// A force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(untagged)]
pub enum CertificateForce {
    /// The coefficients of a polynomial, fractions, that of x^0 first.
    Polynomial(Vec<String>),
    /// An expression in x; `sin` is short for `sin(x)`.
    Expression(String),
}

/// A formula `x~(t) = X~(omega~ t)` with its numbers, and what is proved of them, each from below
/// and from above.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CertificateFormula {
    /// The law as it was derived: `omega = ...` or `omega^2 = ...` with definitions of letters
    /// behind commas, which has to give `omega` at `values` to its last digits. What is of another
    /// form is words: nothing is checked against them.
    pub law: String,
    /// The letters of the answer in the law, where the equation has the usual ones, `A` or `omega`,
    /// for something of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub letters: Option<CertificateLetters>,
    /// The values of the letters in the law, such as `A = 3/2, k = pi/5`; A is x(0) less a place of
    /// rest.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub values: String,
    /// omega~, an integer times 2^-bits.
    pub omega: String,
    /// The cosine coefficients of X~, likewise.
    pub c: Vec<String>,
    /// max |X - X~|, both at the same phase, in the unit of x.
    pub phase_error: [String; 2],
    /// |omega - omega~|.
    pub frequency_error: [String; 2],
    /// max |X~'| |omega - omega~|: |x(t) - x~(t)| <= phase_error + drift |t| for all t.
    pub drift: [String; 2],
}

/// The letters of an answer in its law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CertificateLetters {
    /// That of the amplitude, whose value is x(0) less a place of rest.
    pub amplitude: String,
    /// That of the frequency, on the left side of the law.
    pub frequency: String,
}

/// The document of kind `certificate`.
///
/// ```
/// use lindstedt::certificate::certify;
/// use lindstedt::{Options, Oscillator, solve};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options::default())?;
/// let (certificate, _) = certify(&pendulum, &solution, &"A = 3/2".parse()?)?;
/// let document = lindstedt::export::json::certificate(&certificate);
/// assert_eq!((document.initial_displacement.as_str(), document.nu.as_str()), ("3/2", "1"));
/// assert_eq!(document.read()?, certificate);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn certificate(certificate: &Certificate) -> CertificateDocument {
    CertificateDocument {
        schema: DocumentKind::Certificate.schema().to_owned(),
        ode: EQUATION.to_owned(),
        f: force(&certificate.force),
        initial_displacement: certificate.start.to_string(),
        odd: certificate.odd,
        bits: certificate.bits,
        mu: certificate.mu.to_string(),
        c: texts(&certificate.coefficients),
        highest_harmonic: certificate.highest,
        inverse_bits: certificate.inverse_bits,
        inverse: certificate.inverse.iter().map(texts).collect(),
        sigma_log2: certificate.sigma,
        nu: "1".to_owned(),
        claim_r: claim(&certificate.claim),
        formula: certificate.formula.as_ref().map(formula),
    }
}

/// An upper claim as text: as it is, or rounded up to three digits.
pub(super) fn claim(value: &Rational) -> String {
    short(value, 1, 3)
}

/// A lower and an upper claim as text, rounded outwards likewise.
pub(super) fn claims([lower, upper]: &[Rational; 2]) -> [String; 2] {
    [short(lower, 0, 3), short(upper, 1, 3)]
}

fn short(value: &Rational, side: usize, digits: usize) -> String {
    let rounded = || significant_fraction(&neighbours(value, digits)[side], digits);
    exact_decimal(value).unwrap_or_else(rounded)
}

/// The stability of a limit cycle or of a driven motion, as it is proved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CertificateStability {
    /// Whether neighbouring motions approach it; false where it is unstable, null where neither is
    /// proved.
    pub attracts: Option<bool>,
    /// The largest modulus of its Floquet multipliers over the period 2 pi of X, from below and from
    /// above; of a limit cycle without the multiplier 1 along the motion. Null where nothing is
    /// known of it.
    pub largest_multiplier: Option<[String; 2]>,
}

/// The claims on the stability as text; `None` if there are none.
pub(super) fn stability(claimed: Option<&ClaimedStability>) -> Option<CertificateStability> {
    /// Decimal digits where the number has no end.
    const DIGITS: usize = 9;
    let ends = |[lower, upper]: &[Rational; 2]| [short(lower, 0, DIGITS), short(upper, 1, DIGITS)];
    claimed.map(|claimed| CertificateStability {
        attracts: claimed.attracts,
        largest_multiplier: claimed.largest.as_ref().map(ends),
    })
}

/// Reads the claims on the stability.
pub(super) fn read_stability(
    document: Option<&CertificateStability>,
) -> Result<Option<ClaimedStability>, JsonError> {
    let Some(document) = document else {
        return Ok(None);
    };
    let ends = document.largest_multiplier.as_ref();
    let largest = ends.map(|ends| range(ends, "largest_multiplier")).transpose()?;
    Ok(Some(ClaimedStability { attracts: document.attracts, largest }))
}

/// The values of letters as text, under the names that they have in the law: the letters in force
/// are in it already.
pub(super) fn values(values: &Values) -> String {
    let equations: Vec<String> =
        values.iter().map(|(name, value)| format!("{} = {value}", name.name())).collect();
    equations.join(", ")
}

/// The values of letters that a text says.
pub(super) fn read_values(text: &str) -> Result<Values, JsonError> {
    let values = Some(text).filter(|text| text.len() <= LONGEST_VALUES);
    let values = values.and_then(|text| text.parse().ok());
    values
        .map_or_else(|| unexpected("values", "names with numbers, such as `A = 3/2, k = pi/5`"), Ok)
}

/// The letters of a law as text, where they are not the usual ones.
pub(super) fn letters(letters: LettersOfLaw) -> Option<CertificateLetters> {
    let document = CertificateLetters {
        amplitude: letters.amplitude.name().to_owned(),
        frequency: letters.frequency.name().to_owned(),
    };
    (letters != LettersOfLaw::default()).then_some(document)
}

/// The letters of a law that are said; the usual ones if none are.
pub(super) fn read_letters(
    document: Option<&CertificateLetters>,
) -> Result<LettersOfLaw, JsonError> {
    let Some(CertificateLetters { amplitude, frequency }) = document else {
        return Ok(LettersOfLaw::default());
    };
    LettersOfLaw::of_names(amplitude, frequency).map_or_else(
        || unexpected("letters", "letters that an answer takes, such as C and Omega"),
        Ok,
    )
}

/// The document of a formula that is judged.
fn formula(formula: &JudgedFormula) -> CertificateFormula {
    CertificateFormula {
        law: formula.law.clone(),
        letters: letters(formula.letters),
        values: values(&formula.values),
        omega: formula.frequency.to_string(),
        c: texts(&formula.coefficients),
        phase_error: claims(&formula.deviation),
        frequency_error: claims(&formula.frequency_error),
        drift: claims(&formula.drift),
    }
}

/// The coefficients of a polynomial, or the text of another force.
pub(super) fn force(force: &Expr) -> CertificateForce {
    let x = coordinate();
    let of_x_alone = force.symbols().iter().all(|name| *name == x);
    let polynomial = force.to_polynomial(&mut |_| None).ok().flatten();
    let coefficients = polynomial.filter(|_| of_x_alone).and_then(|polynomial| {
        let mut coefficients = vec![Rational::zero()];
        for (monomial, coefficient) in polynomial.terms() {
            let power = usize::try_from(monomial.exponent(x)).ok().filter(|power| *power <= 200)?;
            let length = coefficients.len().max(power + 1);
            coefficients.resize(length, Rational::zero());
            coefficients[power] = coefficient.clone();
        }
        Some(coefficients)
    });
    match coefficients {
        Some(coefficients) => CertificateForce::Polynomial(texts(&coefficients)),
        None => match force.to_string() {
            text if text == "sin(x)" => CertificateForce::Expression("sin".to_owned()),
            text => CertificateForce::Expression(text),
        },
    }
}

impl CertificateDocument {
    /// The certificate that is written, with nothing checked but that it is one.
    ///
    /// # Errors
    /// A key that holds something else, or more than a certificate ever has.
    pub fn read(&self) -> Result<Certificate, JsonError> {
        check_kind(&self.schema, DocumentKind::Certificate)?;
        if self.ode != EQUATION {
            return unexpected("ode", "`x''+f(x)=0`");
        }
        check_sizes(
            &self.nu,
            self.highest_harmonic,
            &self.inverse,
            [self.bits, self.inverse_bits],
        )?;
        Ok(Certificate {
            force: self.f.read("f")?,
            start: fraction(&self.initial_displacement, "initial_displacement")?,
            odd: self.odd,
            bits: self.bits,
            mu: integer(&self.mu, "mu")?,
            coefficients: integers(&self.c, "c")?,
            highest: self.highest_harmonic,
            inverse_bits: self.inverse_bits,
            inverse: matrix(&self.inverse)?,
            sigma: self.sigma_log2,
            claim: decimal(&self.claim_r, "claim_r")?,
            formula: self.formula.as_ref().map(CertificateFormula::read).transpose()?,
        })
    }
}

/// Sizes, before any number is read.
pub(super) fn check_sizes(
    nu: &str,
    highest: usize,
    inverse: &[Vec<String>],
    bits: [usize; 2],
) -> Result<(), JsonError> {
    if nu != "1" {
        return unexpected("nu", "`1`, the only weight of this schema");
    }
    let fits = highest <= HIGHEST_HARMONIC && inverse.len() <= HIGHEST_HARMONIC + 2;
    if !fits || inverse.iter().any(|row| row.len() > HIGHEST_HARMONIC + 2) {
        return unexpected(
            "highest_harmonic",
            "at most 400, and `inverse` a square matrix of this size",
        );
    }
    if bits.iter().any(|bits| *bits > MOST_BITS) {
        return unexpected("bits", "at most 224, and so `inverse_bits`");
    }
    Ok(())
}

/// The entries of the inverse.
pub(super) fn matrix(rows: &[Vec<String>]) -> Result<Vec<Vec<Integer>>, JsonError> {
    rows.iter().map(|row| integers(row, "inverse")).collect()
}

impl CertificateFormula {
    fn read(&self) -> Result<JudgedFormula, JsonError> {
        Ok(JudgedFormula {
            law: self.law.clone(),
            letters: read_letters(self.letters.as_ref())?,
            values: read_values(&self.values)?,
            frequency: integer(&self.omega, "omega")?,
            coefficients: integers(&self.c, "formula.c")?,
            sines: vec![],
            others: vec![],
            deviation: range(&self.phase_error, "phase_error")?,
            frequency_error: range(&self.frequency_error, "frequency_error")?,
            drift: range(&self.drift, "drift")?,
            amplitude_error: <[Rational; 2]>::default(),
        })
    }
}

/// Reads the lower and the upper bound of a claim.
pub(super) fn range(ends: &[String; 2], key: &str) -> Result<[Rational; 2], JsonError> {
    Ok([decimal(&ends[0], key)?, decimal(&ends[1], key)?])
}

impl CertificateForce {
    pub(super) fn read(&self, key: &str) -> Result<Expr, JsonError> {
        let x = Expr::from(coordinate());
        match self {
            Self::Expression(text) if text == "sin" => {
                x.sin().or_else(|_| unexpected(key, "an expression in x"))
            }
            Self::Expression(text) if text.len() > LONGEST_FORCE => {
                unexpected(key, "an expression of at most 2000 characters")
            }
            Self::Expression(text) => expression(text, key),
            Self::Polynomial(coefficients) if coefficients.len() > LONGEST_NUMBER => {
                unexpected(key, "a polynomial of a degree below 200")
            }
            Self::Polynomial(coefficients) => {
                let term = |(power, text): (usize, &String)| {
                    let power = x.integer_power(i64::try_from(power).unwrap_or(0));
                    let power = power.or_else(|_| unexpected(key, "a polynomial"))?;
                    Ok(&Expr::number(fraction(text, key)?) * &power)
                };
                let terms: Result<Vec<Expr>, JsonError> =
                    coefficients.iter().enumerate().map(term).collect();
                Ok(Expr::sum(terms?))
            }
        }
    }
}

pub(super) fn integers(texts: &[String], key: &str) -> Result<Vec<Integer>, JsonError> {
    if texts.len() > 2 * HIGHEST_HARMONIC {
        return unexpected(key, "a list of at most 800 numbers");
    }
    texts.iter().map(|text| integer(text, key)).collect()
}

pub(super) fn integer(text: &str, key: &str) -> Result<Integer, JsonError> {
    let number = Some(text).filter(|text| text.len() <= LONGEST_NUMBER);
    let number = number.and_then(|text| text.parse().ok());
    number.map_or_else(|| unexpected(key, "integers of at most 200 characters"), Ok)
}

pub(super) fn fraction(text: &str, key: &str) -> Result<Rational, JsonError> {
    let number = Some(text).filter(|text| text.len() <= LONGEST_NUMBER);
    let number = number.and_then(|text| text.parse().ok());
    number.map_or_else(|| unexpected(key, "a fraction of at most 200 characters"), Ok)
}

/// A decimal, `2.5e-33`, that is not negative.
pub(super) fn decimal(text: &str, key: &str) -> Result<Rational, JsonError> {
    const EXPECTED: &str = "a decimal such as `2.5e-33`, not negative";
    /// Decimal exponents: no double is smaller, and none larger.
    const EXPONENTS: std::ops::RangeInclusive<i32> = -400..=400;
    if text.len() > LONGEST_NUMBER {
        return unexpected(key, EXPECTED);
    }
    let (digits, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let (whole, decimals) = digits.split_once('.').unwrap_or((digits, ""));
    let exponent = exponent.parse().ok().filter(|exponent| EXPONENTS.contains(exponent));
    let plain = (whole.to_owned() + decimals).bytes().all(|byte| byte.is_ascii_digit());
    let count: Option<Integer> =
        (whole.to_owned() + decimals).parse().ok().filter(|_| plain && !whole.is_empty());
    let Some((count, exponent)) = count.zip(exponent) else {
        return unexpected(key, EXPECTED);
    };
    let power = exponent - decimals.len() as i32;
    let ten = Rational::from_integer(Integer::from(10).pow(power.unsigned_abs()));
    let count = Rational::from_integer(count);
    Ok(if power < 0 { count / ten } else { count * ten })
}

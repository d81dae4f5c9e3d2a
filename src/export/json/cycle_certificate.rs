//! Kind `certificate`, of a limit cycle: numbers from which the cycle, and the error of a formula, can be proved.
//!
//! Every number is text, as in the certificate of a conservative motion, from which it is told by `ode`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::certificate::{ForceDocument, check_sizes, decimal, force, integer, integers, matrix, range, short, texts};
use super::schema::check_kind;
use super::{JsonError, Kind, unexpected};
use crate::certificate::{CycleCertificate, JudgedFormula};

/// What `ode` of a certificate of a limit cycle has.
pub const EQUATION_OF_CYCLES: &str = "x''+g(x)*x'+h(x)=0";

/// Numbers from which a limit cycle of `x'' + g(x) x' + h(x) = 0` can be proved, and how far a formula for it is off. All numbers are text:
/// integers, fractions such as `-1/6`, decimals such as `2.5e-33`. The first harmonic of the motion has no sine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(deny_unknown_fields)]
pub struct CycleCertificateDocument {
    /// The kind of document.
    #[schemars(extend("const" = Kind::Certificate.schema()))]
    pub schema: String,
    /// The equation that g and h belong to.
    #[schemars(extend("const" = EQUATION_OF_CYCLES))]
    pub ode: String,
    /// The damping by velocity: the coefficients of a polynomial by rising power of x, or an expression in x.
    pub g: ForceDocument,
    /// The restoring force, likewise.
    pub h: ForceDocument,
    /// Whether g is even, h odd and the motion of odd harmonics alone, and so the block.
    pub odd: bool,
    /// `p`, `c`, `s` and the numbers of the formula are integers times 2^-bits; at most 224.
    pub bits: usize,
    /// The approximate 1/omega.
    pub p: String,
    /// The approximate cosine coefficients of the motion, that of the constant first.
    pub c: Vec<String>,
    /// The approximate sine coefficients by harmonic; the first two, of the constant and of the first harmonic, are 0.
    pub s: Vec<String>,
    /// The last harmonic of the block; at most 400, and the block has at most 401 unknowns.
    #[serde(rename = "K")]
    pub highest: usize,
    /// The entries of `A_block` are integers times 2^-Abits; at most 224.
    #[serde(rename = "Abits")]
    pub inverse_bits: usize,
    /// The approximate inverse of the derivative on the block, row by row. The columns are those of the equations: the sine of the first
    /// harmonic, then cosine and sine of each harmonic, the others; the rows those of the unknowns: p, then the same.
    #[serde(rename = "A_block")]
    pub inverse: Vec<Vec<String>>,
    /// The norm is sigma |p| + sum (|c_k| + |s_k|), sigma = 2^sigma_log2.
    pub sigma_log2: i32,
    /// The weight of a harmonic from one to the next; 1.
    #[schemars(extend("const" = "1"))]
    pub nu: String,
    /// The radius that is claimed: the true p, c and s are so near in the norm.
    pub claim_r: String,
    /// The formula that is judged, turned until its first harmonic is a positive cosine; null where none is.
    pub formula: Option<CycleFormulaDocument>,
}

/// A formula `x~(t) = X~(omega~ t)` with its numbers, and what is proved of them, each from below and from above.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(deny_unknown_fields, rename = "CertificateFormulaOfCycle")]
pub struct CycleFormulaDocument {
    /// The law as it was derived, in words; nothing is checked against it.
    pub law: String,
    /// omega~, an integer times 2^-bits.
    pub omega: String,
    /// The cosine coefficients of X~, that of the constant first, likewise.
    pub c: Vec<String>,
    /// Its sine coefficients by harmonic, likewise.
    pub s: Vec<String>,
    /// max |X - X~|, X~ turned until its first harmonic is a positive cosine, in the unit of x.
    pub phase_error: [String; 2],
    /// |omega - omega~|.
    pub frequency_error: [String; 2],
    /// max |X~'| |omega - omega~|: |x(t) - x~(t)| <= phase_error + drift |t| for all t, both with this phase at t = 0.
    pub drift: [String; 2],
}

/// The document of kind `certificate` of a limit cycle.
///
/// ```
/// use lindstedt::certificate::certify_cycle;
/// use lindstedt::{Options, Oscillator, solve};
///
/// let oscillator = Oscillator::parse("x'' - mu*(1 - x^2)*x' + x = 0")?;
/// let solution = solve(&oscillator, &Options::default())?;
/// let (certificate, _) = certify_cycle(&oscillator, &solution, &"mu = 1/10".parse()?)?;
/// let document = lindstedt::export::json::cycle_certificate(&certificate);
/// assert_eq!(document.ode, "x''+g(x)*x'+h(x)=0");
/// assert_eq!(document.read()?, certificate);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn cycle_certificate(certificate: &CycleCertificate) -> CycleCertificateDocument {
    CycleCertificateDocument {
        schema: Kind::Certificate.schema().to_owned(),
        ode: EQUATION_OF_CYCLES.to_owned(),
        g: force(&certificate.damping),
        h: force(&certificate.force),
        odd: certificate.odd,
        bits: certificate.bits,
        p: certificate.reciprocal.to_string(),
        c: texts(&certificate.cosines),
        s: texts(&certificate.sines),
        highest: certificate.highest,
        inverse_bits: certificate.inverse_bits,
        inverse: certificate.inverse.iter().map(|row| texts(row)).collect(),
        sigma_log2: certificate.sigma,
        nu: "1".to_owned(),
        claim_r: short(&certificate.claim),
        formula: certificate.formula.as_ref().map(formula),
    }
}

fn formula(formula: &JudgedFormula) -> CycleFormulaDocument {
    CycleFormulaDocument {
        law: formula.law.clone(),
        omega: formula.frequency.to_string(),
        c: texts(&formula.coefficients),
        s: texts(&formula.sines),
        phase_error: formula.deviation.each_ref().map(short),
        frequency_error: formula.frequency_error.each_ref().map(short),
        drift: formula.drift.each_ref().map(short),
    }
}

impl CycleFormulaDocument {
    fn read(&self) -> Result<JudgedFormula, JsonError> {
        Ok(JudgedFormula {
            law: self.law.clone(),
            frequency: integer(&self.omega, "omega")?,
            coefficients: integers(&self.c, "formula.c")?,
            sines: integers(&self.s, "formula.s")?,
            deviation: range(&self.phase_error, "phase_error")?,
            frequency_error: range(&self.frequency_error, "frequency_error")?,
            drift: range(&self.drift, "drift")?,
        })
    }
}

impl CycleCertificateDocument {
    /// The certificate that is written, with nothing checked but that it is one.
    ///
    /// # Errors
    /// A key that holds something else, or more than a certificate ever has.
    pub fn read(&self) -> Result<CycleCertificate, JsonError> {
        check_kind(&self.schema, Kind::Certificate)?;
        if self.ode != EQUATION_OF_CYCLES {
            return unexpected("ode", "`x''+g(x)*x'+h(x)=0`");
        }
        check_sizes(&self.nu, self.highest, &self.inverse, [self.bits, self.inverse_bits])?;
        Ok(CycleCertificate {
            damping: self.g.read("g")?,
            force: self.h.read("h")?,
            odd: self.odd,
            bits: self.bits,
            reciprocal: integer(&self.p, "p")?,
            cosines: integers(&self.c, "c")?,
            sines: integers(&self.s, "s")?,
            highest: self.highest,
            inverse_bits: self.inverse_bits,
            inverse: matrix(&self.inverse)?,
            sigma: self.sigma_log2,
            claim: decimal(&self.claim_r, "claim_r")?,
            formula: self.formula.as_ref().map(CycleFormulaDocument::read).transpose()?,
        })
    }
}

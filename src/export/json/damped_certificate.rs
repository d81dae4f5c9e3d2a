//! Kind `certificate`, of a limit cycle or a driven motion: numbers from which it, and the error of
//! a formula, can be proved.
//!
//! Every number is text, as in the certificate of a conservative motion, from which it is told by
//! `ode`.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::certificate::{
    CertificateForce, CertificateLetters, CertificateStability, check_sizes, claim, claims,
    decimal, force, fraction, integer, integers, letters, matrix, range, read_letters,
    read_stability, read_values, stability, values,
};
use super::number::texts;
use super::schema::check_kind;
use super::{DocumentKind, JsonError, unexpected};
use crate::certificate::{DampedCertificate, Drive, JudgedFormula};
use crate::exact::Rational;

/// The form of the equation in `ode` of a certificate of a limit cycle.
pub const EQUATION_OF_CYCLES: &str = "x''+g(x)*x'+h(x)=0";

/// The form of the equation in `ode` of a certificate of a driven motion; c and s are
/// `cos(Omega t)` and `sin(Omega t)`.
pub const EQUATION_WITH_DRIVE: &str = "x''+g(x)*x'+h(x,c,s)=0";

/// Numbers from which a limit cycle of `x'' + g(x) x' + h(x) = 0` can be proved, or a steady motion
/// with a drive in h, and how far a formula for it is off. All numbers are text: integers,
/// fractions such as `-1/6`, decimals such as `2.5e-33`. The first harmonic of a cycle has no sine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DampedCertificateDocument {
    /// The kind of document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = DocumentKind::Certificate.schema())))]
    pub schema: String,
    /// The equation that g and h belong to.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [EQUATION_OF_CYCLES, EQUATION_WITH_DRIVE])))]
    pub ode: String,
    /// The damping by velocity: the coefficients of a polynomial by rising power of x, or an
    /// expression in x.
    pub g: CertificateForce,
    /// The restoring force, likewise; with a drive an expression in x, c = cos(Omega t) and s =
    /// sin(Omega t).
    pub h: CertificateForce,
    /// What drives the motion; not there for a limit cycle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive: Option<CertificateDrive>,
    /// Whether g is even, h odd and the motion of odd harmonics alone, and so the block, and the
    /// only one within claim_r among those; with a drive h is odd in x and in what of c and s
    /// changes its sign after half a period of the motion.
    pub odd: bool,
    /// `p`, `c`, `s` and the numbers of the formula are integers times 2^-bits; at most 224.
    pub bits: usize,
    /// The approximate 1/omega; not there with a drive, n/Omega exactly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub p: Option<String>,
    /// The approximate cosine coefficients of the motion, that of the constant first; of a limit
    /// cycle that of the first harmonic is positive.
    pub c: Vec<String>,
    /// The approximate sine coefficients by harmonic; that of the constant is 0, and of a limit
    /// cycle that of the first harmonic too.
    pub s: Vec<String>,
    /// The last harmonic of the block; at most 400, and the block has at most 401 unknowns.
    #[serde(alias = "K")]
    pub highest_harmonic: usize,
    /// The entries of `inverse` are integers times 2^-inverse_bits; at most 224.
    #[serde(alias = "Abits")]
    pub inverse_bits: usize,
    /// The approximate inverse of the derivative on the block, row by row. The columns are those of
    /// the equations: the sine of the first harmonic, then cosine and sine of each harmonic, the
    /// others; the rows those of the unknowns: p, then the same. With a drive both are cosine and
    /// sine of each harmonic.
    #[serde(alias = "A_block")]
    pub inverse: Vec<Vec<String>>,
    /// The norm is sigma |p| + sum (|c_k| + |s_k|), sigma = 2^sigma_log2; 0 with a drive, where
    /// there is no p.
    pub sigma_log2: i32,
    /// The weight of a harmonic from one to the next; 1.
    #[cfg_attr(feature = "schema", schemars(extend("const" = "1")))]
    pub nu: String,
    /// The radius that is claimed: there is exactly one motion whose p, c and s are so near in the
    /// norm, where `odd` exactly one of odd harmonics.
    pub claim_r: String,
    /// The stability that is claimed; not there in certificates that claim none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<CertificateStability>,
    /// The formula that is judged, of a limit cycle turned until its first harmonic is a positive
    /// cosine; null where none is.
    pub formula: Option<CertificateFormulaOfCycle>,
}

/// What drives a motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CertificateDrive {
    /// The driving frequency Omega, a positive fraction, exact.
    #[serde(alias = "Omega")]
    pub driving_frequency: String,
    /// How many periods of the drive the motion takes: x(t) = X(Omega t/n).
    #[serde(rename = "n")]
    pub periods: usize,
    /// The harmonic of the motion whose amplitude the formula is about.
    pub harmonic: usize,
}

/// A formula `x~(t) = X~(omega~ t)` with its numbers, and what is proved of them, each from below
/// and from above.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CertificateFormulaOfCycle {
    /// The law as it was derived: of a cycle `omega = ...` or `omega^2 = ...`, with a drive
    /// `x = ...` in t, with definitions of letters behind commas; it has to give `omega`, with a
    /// drive `c` and `s`, at `values` to the last digits. What is of another form is words: nothing
    /// is checked against them.
    pub law: String,
    /// The letters of the answer in the law, where the equation has the usual ones, `A` or `omega`,
    /// for something of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub letters: Option<CertificateLetters>,
    /// The values of the letters in the law.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub values: String,
    /// omega~, an integer times 2^-bits; not there with a drive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub omega: Option<String>,
    /// The cosine coefficients of X~, that of the constant first, likewise.
    pub c: Vec<String>,
    /// Its sine coefficients by harmonic, likewise.
    pub s: Vec<String>,
    /// max |X - X~|, in the unit of x, X~ of a limit cycle turned until its first harmonic is a
    /// positive cosine; of the nearest of the motions that follow from X by symmetries of the
    /// equation: with a drive any number of its periods later, of an equation that is its own
    /// mirror image -X too.
    pub phase_error: [String; 2],
    /// |omega - omega~|; not there with a drive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency_error: Option<[String; 2]>,
    /// max |X~'| |omega - omega~|: |x(t) - x~(t)| <= phase_error + drift |t| for all t, both with
    /// this phase at t = 0; not there with a drive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drift: Option<[String; 2]>,
    /// |a - a~|, the amplitudes of the drive's harmonic; not there for a limit cycle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude_error: Option<[String; 2]>,
}

/// The document of kind `certificate` of a limit cycle or a driven motion.
///
/// ```
/// use lindstedt::certificate::certify_cycle;
/// use lindstedt::{Options, Oscillator, solve};
///
/// let oscillator = Oscillator::parse("x'' - mu*(1 - x^2)*x' + x = 0")?;
/// let solution = solve(&oscillator, &Options::default())?;
/// let (certificate, _) = certify_cycle(&oscillator, &solution, &"mu = 1/10".parse()?)?;
/// let document = lindstedt::export::json::damped_certificate(&certificate);
/// assert_eq!(document.ode, "x''+g(x)*x'+h(x)=0");
/// assert_eq!(document.read()?, certificate);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn damped_certificate(certificate: &DampedCertificate) -> DampedCertificateDocument {
    DampedCertificateDocument {
        schema: DocumentKind::Certificate.schema().to_owned(),
        ode: match certificate.drive {
            None => EQUATION_OF_CYCLES.to_owned(),
            Some(_) => EQUATION_WITH_DRIVE.to_owned(),
        },
        g: force(&certificate.damping),
        h: force(&certificate.force),
        drive: certificate.drive.as_ref().map(CertificateDrive::of),
        odd: certificate.odd,
        bits: certificate.bits,
        p: certificate.drive.is_none().then(|| certificate.reciprocal.to_string()),
        c: texts(&certificate.cosines),
        s: texts(&certificate.sines),
        highest_harmonic: certificate.highest,
        inverse_bits: certificate.inverse_bits,
        inverse: certificate.inverse.iter().map(texts).collect(),
        sigma_log2: certificate.sigma,
        nu: "1".to_owned(),
        claim_r: claim(&certificate.claim),
        stability: stability(certificate.stability.as_ref()),
        formula: certificate
            .formula
            .as_ref()
            .map(|judged| formula(judged, certificate.drive.is_some())),
    }
}

fn formula(formula: &JudgedFormula, is_driven: bool) -> CertificateFormulaOfCycle {
    CertificateFormulaOfCycle {
        law: formula.law.clone(),
        letters: letters(formula.letters),
        values: values(&formula.values),
        omega: (!is_driven).then(|| formula.frequency.to_string()),
        c: texts(&formula.coefficients),
        s: texts(&formula.sines),
        phase_error: claims(&formula.deviation),
        frequency_error: (!is_driven).then(|| claims(&formula.frequency_error)),
        drift: (!is_driven).then(|| claims(&formula.drift)),
        amplitude_error: is_driven.then(|| claims(&formula.amplitude_error)),
    }
}

impl CertificateFormulaOfCycle {
    fn read(&self, is_driven: bool) -> Result<JudgedFormula, JsonError> {
        let of_cycle = [self.omega.is_some(), self.frequency_error.is_some(), self.drift.is_some()];
        if of_cycle != [!is_driven; 3] || self.amplitude_error.is_some() != is_driven {
            return unexpected(
                "formula",
                "`omega`, `frequency_error` and `drift`, or with a drive `amplitude_error`",
            );
        }
        let both = |claims: &Option<[String; 2]>, key| match claims {
            Some(claims) => range(claims, key),
            None => Ok(<[Rational; 2]>::default()),
        };
        Ok(JudgedFormula {
            law: self.law.clone(),
            letters: read_letters(self.letters.as_ref())?,
            values: read_values(&self.values)?,
            frequency: integer(self.omega.as_deref().unwrap_or("0"), "omega")?,
            coefficients: integers(&self.c, "formula.c")?,
            sines: integers(&self.s, "formula.s")?,
            others: vec![],
            deviation: range(&self.phase_error, "phase_error")?,
            frequency_error: both(&self.frequency_error, "frequency_error")?,
            drift: both(&self.drift, "drift")?,
            amplitude_error: both(&self.amplitude_error, "amplitude_error")?,
        })
    }
}

impl CertificateDrive {
    pub(super) fn of(drive: &Drive) -> Self {
        Self {
            driving_frequency: drive.frequency.to_string(),
            periods: drive.periods,
            harmonic: drive.harmonic,
        }
    }

    pub(super) fn read(&self) -> Result<Drive, JsonError> {
        Ok(Drive {
            frequency: fraction(&self.driving_frequency, "drive.driving_frequency")?,
            periods: self.periods,
            harmonic: self.harmonic,
        })
    }
}

impl DampedCertificateDocument {
    /// The certificate that is written, with nothing checked but that it is one.
    ///
    /// # Errors
    /// A key that holds something else, or more than a certificate ever has.
    pub fn read(&self) -> Result<DampedCertificate, JsonError> {
        check_kind(&self.schema, DocumentKind::Certificate)?;
        let is_driven = self.drive.is_some();
        let expected = if is_driven { EQUATION_WITH_DRIVE } else { EQUATION_OF_CYCLES };
        if self.ode != expected || self.p.is_some() == is_driven {
            return unexpected(
                "ode",
                "`x''+g(x)*x'+h(x)=0` with `p`, or `x''+g(x)*x'+h(x,c,s)=0` with `drive`",
            );
        }
        check_sizes(
            &self.nu,
            self.highest_harmonic,
            &self.inverse,
            [self.bits, self.inverse_bits],
        )?;
        Ok(DampedCertificate {
            damping: self.g.read("g")?,
            force: self.h.read("h")?,
            drive: self.drive.as_ref().map(CertificateDrive::read).transpose()?,
            odd: self.odd,
            bits: self.bits,
            reciprocal: integer(self.p.as_deref().unwrap_or("0"), "p")?,
            cosines: integers(&self.c, "c")?,
            sines: integers(&self.s, "s")?,
            highest: self.highest_harmonic,
            inverse_bits: self.inverse_bits,
            inverse: matrix(&self.inverse)?,
            sigma: self.sigma_log2,
            claim: decimal(&self.claim_r, "claim_r")?,
            stability: read_stability(self.stability.as_ref())?,
            formula: self.formula.as_ref().map(|formula| formula.read(is_driven)).transpose()?,
        })
    }
}

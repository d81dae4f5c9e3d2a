//! Kind `certificate`, of a driven motion of several coordinates: numbers from which it can be
//! proved.
//!
//! Every number is text, as in the certificate of one coordinate, from which it is told by `ode`.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::certificate::{check_sizes, claim, decimal, fraction, integers, matrix};
use super::damped_certificate::CertificateDrive;
use super::mode_certificate::{MOST_COORDINATES, read_coordinates, short_expression};
use super::number::texts;
use super::schema::check_kind;
use super::{DocumentKind, JsonError, unexpected};
use crate::certificate::{CoupledCertificate, Drive};
use crate::exact::Integer;
use crate::expr::Expr;

/// The form of the equations in `ode` of a certificate of a driven motion of several coordinates; c
/// and s are `cos(Omega t)` and `sin(Omega t)`.
pub const EQUATIONS_WITH_DRIVE: &str = "q''+g(q)*q'+h(q,c,s)=0";

/// Numbers from which a steady motion of several coordinates with a drive,
/// `q'' + g(q) q' + h(q, cos(Omega t), sin(Omega t)) = 0`, can be proved. All numbers are text:
/// integers, fractions such as `-1/6`, decimals such as `2.5e-33`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CoupledCertificateDocument {
    /// The kind of document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = DocumentKind::Certificate.schema())))]
    pub schema: String,
    /// The equations that g and h belong to.
    #[cfg_attr(feature = "schema", schemars(extend("const" = EQUATIONS_WITH_DRIVE)))]
    pub ode: String,
    /// The names of the coordinates, none of them c or s.
    pub coordinates: Vec<String>,
    /// The damping by velocities, expressions in the coordinates: a row for each equation, which is
    /// the derivative of a function of the coordinates, dg_ij/dq_l = dg_il/dq_j.
    pub g: Vec<Vec<String>>,
    /// The force of each equation, an expression in the coordinates, c = cos(Omega t) and
    /// s = sin(Omega t): the mass matrix is inverted already.
    pub h: Vec<String>,
    /// What drives the motion; `harmonic` is the one whose amplitudes are proved.
    pub drive: CertificateDrive,
    /// Whether every g is even, every h odd and the motion of odd harmonics alone, and so the block,
    /// and the only one within claim_r among those; h is odd in the coordinates and in what of c and
    /// s changes its sign after half a period of the motion.
    pub odd: bool,
    /// `c` and `s` are integers times 2^-bits; at most 224.
    pub bits: usize,
    /// The approximate cosine coefficients of each coordinate, that of the constant first.
    pub c: Vec<Vec<String>>,
    /// The approximate sine coefficients of each coordinate by harmonic; that of the constant is 0.
    pub s: Vec<Vec<String>>,
    /// The last harmonic of the block; at most 400, and the block has at most 401 unknowns.
    pub highest_harmonic: usize,
    /// The entries of `inverse` are integers times 2^-inverse_bits; at most 224.
    pub inverse_bits: usize,
    /// The weight of a harmonic from one to the next; 1.
    #[cfg_attr(feature = "schema", schemars(extend("const" = "1")))]
    pub nu: String,
    /// The radius that is claimed: there is exactly one motion whose c and s are so near in the norm
    /// sum (|c_ik| + |s_ik|), where `odd` exactly one of odd harmonics.
    pub claim_r: String,
    /// The approximate inverse of the derivative on the block, row by row: cosine and sine of each
    /// harmonic, those of one coordinate after those of the other.
    pub inverse: Vec<Vec<String>>,
}

/// The document of kind `certificate` of a driven motion of several coordinates.
///
/// ```
/// use lindstedt::certificate::certify_coupled;
/// use lindstedt::coupled::CoupledEquations;
///
/// let pair = "x'' + x'/10 + 2*x - y = cos(Omega*t)/4; y'' + y'/10 + 2*y - x = 0";
/// let equations = CoupledEquations::parse(pair)?;
/// let (certificate, _) = certify_coupled(&equations, &"Omega = 11/10".parse()?)?;
/// let document = lindstedt::export::json::coupled_certificate(&certificate);
/// assert_eq!(document.h[1], "-x + 2*y");
/// assert_eq!(document.read()?, certificate);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn coupled_certificate(certificate: &CoupledCertificate) -> CoupledCertificateDocument {
    let lists = |lists: &[Vec<Integer>]| lists.iter().map(texts).collect();
    CoupledCertificateDocument {
        schema: DocumentKind::Certificate.schema().to_owned(),
        ode: EQUATIONS_WITH_DRIVE.to_owned(),
        coordinates: texts(&certificate.coordinates),
        g: certificate.damping.iter().map(texts).collect(),
        h: texts(&certificate.forces),
        drive: CertificateDrive {
            driving_frequency: certificate.drive.frequency.to_string(),
            periods: certificate.drive.periods,
            harmonic: certificate.drive.harmonic,
        },
        odd: certificate.odd,
        bits: certificate.bits,
        c: lists(&certificate.cosines),
        s: lists(&certificate.sines),
        highest_harmonic: certificate.highest,
        inverse_bits: certificate.inverse_bits,
        nu: "1".to_owned(),
        claim_r: claim(&certificate.claim),
        inverse: lists(&certificate.inverse),
    }
}

impl CoupledCertificateDocument {
    /// The certificate that is written, with nothing checked but that it is one.
    ///
    /// # Errors
    /// A key that holds something else, or more than a certificate ever has.
    pub fn read(&self) -> Result<CoupledCertificate, JsonError> {
        check_kind(&self.schema, DocumentKind::Certificate)?;
        if self.ode != EQUATIONS_WITH_DRIVE {
            return unexpected("ode", "`q''+g(q)*q'+h(q,c,s)=0`");
        }
        check_sizes(
            &self.nu,
            self.highest_harmonic,
            &self.inverse,
            [self.bits, self.inverse_bits],
        )?;
        let rows = self.g.iter().map(Vec::len);
        let counts =
            [self.coordinates.len(), self.g.len(), self.h.len(), self.c.len(), self.s.len()];
        if counts.into_iter().chain(rows).any(|count| count > MOST_COORDINATES) {
            return unexpected("coordinates", "at most 40 names");
        }
        let expressions = |texts: &[String], key: &str| -> Result<Vec<Expr>, JsonError> {
            texts.iter().map(|text| short_expression(text, key)).collect()
        };
        let lists = |lists: &[Vec<String>], key: &str| -> Result<Vec<Vec<Integer>>, JsonError> {
            lists.iter().map(|list| integers(list, key)).collect()
        };
        Ok(CoupledCertificate {
            coordinates: read_coordinates(&self.coordinates)?,
            damping: self.g.iter().map(|row| expressions(row, "g")).collect::<Result<_, _>>()?,
            forces: expressions(&self.h, "h")?,
            drive: Drive {
                frequency: fraction(&self.drive.driving_frequency, "driving_frequency")?,
                periods: self.drive.periods,
                harmonic: self.drive.harmonic,
            },
            odd: self.odd,
            bits: self.bits,
            cosines: lists(&self.c, "c")?,
            sines: lists(&self.s, "s")?,
            highest: self.highest_harmonic,
            inverse_bits: self.inverse_bits,
            inverse: matrix(&self.inverse)?,
            claim: decimal(&self.claim_r, "claim_r")?,
        })
    }
}

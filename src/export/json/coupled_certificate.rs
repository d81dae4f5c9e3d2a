//! Kind `certificate`, of a limit cycle or a driven motion of several coordinates: numbers from
//! which it can be proved.
//!
//! Every number is text, as in the certificate of one coordinate, from which it is told by `ode`.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::certificate::{
    CertificateStability, check_sizes, claim, decimal, integer, integers, matrix, read_stability,
    stability,
};
use super::damped_certificate::CertificateDrive;
use super::mode_certificate::{MOST_COORDINATES, read_coordinates, short_expression};
use super::number::texts;
use super::schema::check_kind;
use super::{DocumentKind, JsonError, unexpected};
use crate::certificate::CoupledCertificate;
use crate::exact::Integer;
use crate::expr::Expr;

/// The form of the equations in `ode` of a certificate of a driven motion of several coordinates; c
/// and s are `cos(Omega t)` and `sin(Omega t)`.
pub const EQUATIONS_WITH_DRIVE: &str = "q''+g(q)*q'+h(q,c,s)=0";

/// The form of the equations in `ode` of a certificate of a limit cycle of several coordinates.
pub const EQUATIONS_OF_CYCLES: &str = "q''+g(q)*q'+h(q)=0";

/// Numbers from which a limit cycle of several coordinates, `q'' + g(q) q' + h(q) = 0`, can be
/// proved, or a steady motion with a drive in h. All numbers are text: integers, fractions such as
/// `-1/6`, decimals such as `2.5e-33`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CoupledCertificateDocument {
    /// The kind of document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = DocumentKind::Certificate.schema())))]
    pub schema: String,
    /// The equations that g and h belong to.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [EQUATIONS_OF_CYCLES, EQUATIONS_WITH_DRIVE])))]
    pub ode: String,
    /// The names of the coordinates, with a drive none of them c or s.
    pub coordinates: Vec<String>,
    /// The damping by velocities, expressions in the coordinates: a row for each equation, which is
    /// the derivative of a function of the coordinates, dg_ij/dq_l = dg_il/dq_j.
    pub g: Vec<Vec<String>>,
    /// The force of each equation, an expression in the coordinates, with a drive also in
    /// c = cos(Omega t) and s = sin(Omega t): the mass matrix is inverted already.
    pub h: Vec<String>,
    /// What drives the motion; `harmonic` is the one whose amplitudes are proved. Not there for a
    /// limit cycle, of which those of the first are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive: Option<CertificateDrive>,
    /// The name of the coordinate whose first harmonic is a positive cosine; not there with a drive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phase_of: Option<String>,
    /// Whether every g is even, every h odd and the motion of odd harmonics alone, and so the block,
    /// and the only one within claim_r among those; h is odd in the coordinates and in what of c and
    /// s changes its sign after half a period of the motion.
    pub odd: bool,
    /// `p`, `c` and `s` are integers times 2^-bits; at most 224.
    pub bits: usize,
    /// The approximate 1/omega; not there with a drive, n/Omega exactly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub p: Option<String>,
    /// The approximate cosine coefficients of each coordinate, that of the constant first.
    pub c: Vec<Vec<String>>,
    /// The approximate sine coefficients of each coordinate by harmonic; that of the constant is 0,
    /// and so is that of the first harmonic of `phase_of`.
    pub s: Vec<Vec<String>>,
    /// The last harmonic of the block; at most 400, and the block has at most 401 unknowns.
    pub highest_harmonic: usize,
    /// The entries of `inverse` are integers times 2^-inverse_bits; at most 224.
    pub inverse_bits: usize,
    /// The weight of a harmonic from one to the next; 1.
    #[cfg_attr(feature = "schema", schemars(extend("const" = "1")))]
    pub nu: String,
    /// The norm is sigma |p| + sum (|c_ik| + |s_ik|), sigma = 2^sigma_log2; not there with a drive,
    /// where there is no p.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma_log2: Option<i32>,
    /// The radius that is claimed: there is exactly one motion whose p, c and s are so near in the
    /// norm, where `odd` exactly one of odd harmonics.
    pub claim_r: String,
    /// The stability that is claimed; not there in certificates that claim none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<CertificateStability>,
    /// The approximate inverse of the derivative on the block, row by row: cosine and sine of each
    /// harmonic, those of one coordinate after those of the other. Of a limit cycle the columns begin
    /// with the sine of the first harmonic of `phase_of`, and the rows with p, then the others follow.
    pub inverse: Vec<Vec<String>>,
}

/// The document of kind `certificate` of a limit cycle or a driven motion of several coordinates.
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
    let is_cycle = certificate.drive.is_none();
    let phase = certificate.coordinates.get(certificate.phase).filter(|_| is_cycle);
    let ode = if is_cycle { EQUATIONS_OF_CYCLES } else { EQUATIONS_WITH_DRIVE };
    CoupledCertificateDocument {
        schema: DocumentKind::Certificate.schema().to_owned(),
        ode: ode.to_owned(),
        coordinates: texts(&certificate.coordinates),
        g: certificate.damping.iter().map(texts).collect(),
        h: texts(&certificate.forces),
        drive: certificate.drive.as_ref().map(CertificateDrive::of),
        phase_of: phase.map(ToString::to_string),
        odd: certificate.odd,
        bits: certificate.bits,
        p: is_cycle.then(|| certificate.reciprocal.to_string()),
        c: lists(&certificate.cosines),
        s: lists(&certificate.sines),
        highest_harmonic: certificate.highest,
        inverse_bits: certificate.inverse_bits,
        nu: "1".to_owned(),
        sigma_log2: is_cycle.then_some(certificate.sigma),
        claim_r: claim(&certificate.claim),
        stability: stability(certificate.stability.as_ref()),
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
        let is_cycle = self.drive.is_none();
        let expected = if is_cycle { EQUATIONS_OF_CYCLES } else { EQUATIONS_WITH_DRIVE };
        let of_cycle = [self.p.is_some(), self.phase_of.is_some(), self.sigma_log2.is_some()];
        if self.ode != expected || of_cycle != [is_cycle; 3] {
            return unexpected(
                "ode",
                "`q''+g(q)*q'+h(q)=0` with `p`, `phase_of` and `sigma_log2`, or `q''+g(q)*q'+h(q,c,s)=0` with `drive`",
            );
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
        let place = |name: &String| self.coordinates.iter().position(|other| other == name);
        let phase = match &self.phase_of {
            None => 0,
            Some(name) => place(name)
                .map_or_else(|| unexpected("phase_of", "the name of a coordinate"), Ok)?,
        };
        Ok(CoupledCertificate {
            coordinates: read_coordinates(&self.coordinates)?,
            damping: self.g.iter().map(|row| expressions(row, "g")).collect::<Result<_, _>>()?,
            forces: expressions(&self.h, "h")?,
            drive: self.drive.as_ref().map(CertificateDrive::read).transpose()?,
            phase,
            odd: self.odd,
            bits: self.bits,
            reciprocal: integer(self.p.as_deref().unwrap_or("0"), "p")?,
            cosines: lists(&self.c, "c")?,
            sines: lists(&self.s, "s")?,
            highest: self.highest_harmonic,
            inverse_bits: self.inverse_bits,
            inverse: matrix(&self.inverse)?,
            sigma: self.sigma_log2.unwrap_or(0),
            claim: decimal(&self.claim_r, "claim_r")?,
            stability: read_stability(self.stability.as_ref())?,
        })
    }
}

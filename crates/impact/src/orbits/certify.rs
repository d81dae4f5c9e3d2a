//! Certificates of impact orbits: the orbits that were found, each proved in balls.
//!
//! In: a question whose numbers are fractions, and orbits in doubles. Out: an
//! [`OrbitCertificate`] of all that are proved, and for each orbit its proof or the reason why there is none.
//! The doubles are no more than a start: the proof is that of the numbers as they were typed.

use super::equation::{BiasedHarmonic, ImpactEquation};
use super::error::OrbitError;
use super::{FoundOrbits, ImpactOrbit};
use crate::certificate::{
    CertifiedOrbit, ClaimedOrbit, ExactHarmonic, ExactWall, OrbitCertificate, OrbitNotProved,
    WalledOscillator, certify_orbit,
};
use crate::exact::Rational;
use crate::expr::Expr;
use crate::interrupt::Interrupt;
use crate::values::Values;

/// The proofs of orbits.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitProofs {
    /// The certificate, which has the orbits that are proved.
    pub certificate: OrbitCertificate,
    /// For each orbit its proof, or the reason why it has none; `None` for an orbit that no motion
    /// follows.
    pub proofs: Vec<Option<Result<CertifiedOrbit, OrbitNotProved>>>,
}

impl OrbitProofs {
    /// Whether every orbit that a motion follows is proved; `false` if there is none.
    pub fn all_proved(&self) -> bool {
        let mut followed = self.proofs.iter().flatten().peekable();
        followed.peek().is_some() && followed.all(Result::is_ok)
    }
}

/// Proves the orbits that were found.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::interrupt::Interrupt;
/// use lindstedt::{Oscillator, orbits::{self, ImpactEquation, OrbitRequest}, wall::Wall};
///
/// let beam = Oscillator::parse("x'' + c*x' + k*x = F*cos(w*t)")?;
/// let wall = Wall::parse("x < d", &"e".parse()?)?;
/// let question = ImpactEquation::new(&beam, &wall)?;
/// let values = "c = 0.1, k = 1, F = 1, w = 1, d = 1, e = 0.8".parse()?;
/// let request = OrbitRequest { periods: [1, 1], ..OrbitRequest::default() };
/// let found = orbits::find_orbits(&question, &values, &request)?;
/// let proofs = orbits::certify_orbits(&question, &found, Interrupt::default())?;
/// assert!(proofs.all_proved());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`OrbitError::NotCertified`] for a number that is no fraction.
pub fn certify_orbits(
    question: &ImpactEquation,
    found: &FoundOrbits,
    interrupt: Interrupt,
) -> Result<OrbitProofs, OrbitError> {
    let oscillator = exact_numbers(question, &found.at)?;
    let (mut orbits, mut proofs) = (Vec::new(), Vec::new());
    for own in &found.orbits {
        if interrupt.is_requested() {
            return Err(OrbitError::Interrupted);
        }
        proofs.push(own.orbit.is_admissible().then(|| {
            let (claimed, proved) = certified(&oscillator, &own.orbit, found.frequency)?;
            orbits.push(claimed);
            Ok(proved)
        }));
    }
    let certificate = OrbitCertificate { oscillator, bits: OrbitCertificate::BITS, orbits };
    Ok(OrbitProofs { certificate, proofs })
}

/// The proof of an orbit.
fn certified(
    oscillator: &WalledOscillator,
    orbit: &ImpactOrbit,
    frequency: f64,
) -> Result<(ClaimedOrbit, CertifiedOrbit), OrbitNotProved> {
    let impacts: Vec<(usize, f64, f64)> =
        orbit.impacts.iter().map(|own| (own.wall, frequency * own.time, own.speed)).collect();
    certify_orbit(oscillator, orbit.periods, &impacts)
}

/// The numbers of a question at values, which have to be fractions.
fn exact_numbers(
    question: &ImpactEquation,
    values: &Values,
) -> Result<WalledOscillator, OrbitError> {
    let exact = values.iter().map(|(name, value)| (name, value.clone())).collect();
    let fraction = |what: &'static str, quantity: &Expr| -> Result<Rational, OrbitError> {
        let value = quantity.substitute_all(&exact)?.expand()?;
        value.as_number().cloned().ok_or_else(|| {
            OrbitError::NotCertified(OrbitNotProved::NoFraction { what, value: value.to_string() })
        })
    };
    let harmonic = |what: &'static str, own: &BiasedHarmonic<Expr>, sign: i64| {
        let part = |quantity: &Expr| {
            Ok::<_, OrbitError>(fraction(what, quantity)? * Rational::from_integer(sign.into()))
        };
        Ok::<_, OrbitError>(ExactHarmonic {
            constant: part(&own.constant)?,
            cosine: part(&own.cosine)?,
            sine: part(&own.sine)?,
        })
    };
    let walls = question.walls.iter().map(|wall| {
        // The gap is the place less x above, and x less the place below.
        Ok(ExactWall {
            is_above: wall.side < 0,
            place: harmonic("the place of a wall", &wall.offset, -i64::from(wall.side))?,
            restitution: fraction("the coefficient of restitution", &wall.wall.restitution)?,
        })
    });
    Ok(WalledOscillator {
        damping: fraction("the damping", &question.damping)?,
        stiffness: fraction("the stiffness", &question.stiffness)?,
        frequency: fraction("the frequency of the drive", &question.frequency)?,
        load: harmonic("the force", &question.load, 1)?,
        walls: walls.collect::<Result<_, OrbitError>>()?,
    })
}

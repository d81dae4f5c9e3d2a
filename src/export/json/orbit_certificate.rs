//! Kind `certificate`, of periodic impact orbits: numbers from which they can be proved.
//!
//! Every number is text, as in the certificate of a motion without walls, from which it is told by `ode`.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::certificate::{
    CertificateStability, claim, decimal, fraction, integer, read_stability, stability,
};
use super::schema::check_kind;
use super::{DocumentKind, JsonError, unexpected};
use crate::certificate::{
    ClaimedImpact, ClaimedOrbit, ClaimedStability, ExactHarmonic, ExactWall, OrbitCertificate,
    WalledOscillator,
};

/// The form of the equation in `ode` of a certificate of impact orbits.
pub const EQUATION_WITH_WALLS: &str = "x''+c*x'+k*x=constant+cosine*cos(Omega*t)+sine*sin(Omega*t)";

/// A list of a certificate of impact orbits has at most so many entries.
const LONGEST_LIST: usize = 1000;

/// Numbers from which periodic orbits of a linear driven oscillator between rigid walls can be proved. All
/// numbers are text: integers, fractions such as `-1/6`, decimals such as `2.5e-33`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct OrbitCertificateDocument {
    /// The kind of document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = DocumentKind::Certificate.schema())))]
    pub schema: String,
    /// The equation between impacts; `constant`, `cosine` and `sine` are those of `load`.
    #[cfg_attr(feature = "schema", schemars(extend("const" = EQUATION_WITH_WALLS)))]
    pub ode: String,
    /// The damping, a fraction.
    pub c: String,
    /// The stiffness, a fraction.
    pub k: String,
    /// Omega, a positive fraction.
    pub driving_frequency: String,
    /// The right side of the equation.
    pub load: CertificateWave,
    /// One wall, or one on each side.
    pub walls: Vec<CertificateWall>,
    /// `phase` and `speed` of an impact are integers times 2^-bits; at most 224.
    pub bits: usize,
    /// The orbits.
    pub orbits: Vec<CertificateOrbit>,
}

/// A constant and a wave of the drive, three fractions: `constant + cosine*cos(Omega*t) + sine*sin(Omega*t)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CertificateWave {
    /// The constant.
    pub constant: String,
    /// The factor of the cosine.
    pub cosine: String,
    /// The factor of the sine.
    pub sine: String,
}

/// A rigid wall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CertificateWall {
    /// `above` where the motion is at x < place, `below` where it is at x > place.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["above", "below"])))]
    pub side: String,
    /// The place.
    pub place: CertificateWave,
    /// The coefficient of restitution, a fraction from 0 to 1.
    pub restitution: String,
}

/// An orbit, and what is claimed of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CertificateOrbit {
    /// The periods of the drive in a period of the orbit.
    pub periods: u32,
    /// The approximate impacts in a period, in order of time.
    pub impacts: Vec<CertificateImpact>,
    /// The phase of each impact is so near.
    pub phase_radius: String,
    /// The speed of each impact is so near.
    pub speed_radius: String,
    /// No other orbit with impacts on these walls in this order has all phases so near, and all speeds
    /// within `isolated_in_speed`.
    pub isolated_in_phase: String,
    /// See `isolated_in_phase`.
    pub isolated_in_speed: String,
    /// The stability that is claimed.
    pub stability: CertificateStability,
}

/// An impact of an orbit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CertificateImpact {
    /// The number of the wall in `walls`, from 1 on.
    pub wall: usize,
    /// Omega times the time of the impact, an integer times 2^-bits.
    pub phase: String,
    /// The speed relative to the wall just before the impact, an integer times 2^-bits.
    pub speed: String,
}

/// The document of kind `certificate` of impact orbits.
pub fn orbit_certificate(certificate: &OrbitCertificate) -> OrbitCertificateDocument {
    let WalledOscillator { damping, stiffness, frequency, load, walls } = &certificate.oscillator;
    let wall = |own: &ExactWall| CertificateWall {
        side: if own.is_above { "above" } else { "below" }.to_owned(),
        place: CertificateWave::of(&own.place),
        restitution: own.restitution.to_string(),
    };
    OrbitCertificateDocument {
        schema: DocumentKind::Certificate.schema().to_owned(),
        ode: EQUATION_WITH_WALLS.to_owned(),
        c: damping.to_string(),
        k: stiffness.to_string(),
        driving_frequency: frequency.to_string(),
        load: CertificateWave::of(load),
        walls: walls.iter().map(wall).collect(),
        bits: certificate.bits,
        orbits: certificate.orbits.iter().map(CertificateOrbit::of).collect(),
    }
}

impl CertificateWave {
    fn of(own: &ExactHarmonic) -> Self {
        let [constant, cosine, sine] =
            [&own.constant, &own.cosine, &own.sine].map(ToString::to_string);
        Self { constant, cosine, sine }
    }

    fn read(&self, key: &str) -> Result<ExactHarmonic, JsonError> {
        Ok(ExactHarmonic {
            constant: fraction(&self.constant, key)?,
            cosine: fraction(&self.cosine, key)?,
            sine: fraction(&self.sine, key)?,
        })
    }
}

impl CertificateWall {
    fn read(&self) -> Result<ExactWall, JsonError> {
        let is_above = match self.side.as_str() {
            "above" => true,
            "below" => false,
            _ => return unexpected("side", "`above` or `below`"),
        };
        Ok(ExactWall {
            is_above,
            place: self.place.read("place")?,
            restitution: fraction(&self.restitution, "restitution")?,
        })
    }
}

impl CertificateOrbit {
    fn of(own: &ClaimedOrbit) -> Self {
        let impact = |own: &ClaimedImpact| CertificateImpact {
            wall: own.wall + 1,
            phase: own.phase.to_string(),
            speed: own.speed.to_string(),
        };
        let [phase, speed] = &own.radii;
        let [isolated_in_phase, isolated_in_speed] = &own.isolation;
        Self {
            periods: own.periods,
            impacts: own.impacts.iter().map(impact).collect(),
            phase_radius: claim(phase),
            speed_radius: claim(speed),
            isolated_in_phase: claim(isolated_in_phase),
            isolated_in_speed: claim(isolated_in_speed),
            stability: stability(Some(&own.stability))
                .unwrap_or(CertificateStability { attracts: None, largest_multiplier: None }),
        }
    }

    fn read(&self) -> Result<ClaimedOrbit, JsonError> {
        let impact = |own: &CertificateImpact| {
            let Some(wall) = own.wall.checked_sub(1) else {
                return unexpected("wall", "the number of a wall, from 1 on");
            };
            Ok(ClaimedImpact {
                wall,
                phase: integer(&own.phase, "phase")?,
                speed: integer(&own.speed, "speed")?,
            })
        };
        check_length(&self.impacts, "impacts")?;
        let stability = read_stability(Some(&self.stability))?;
        Ok(ClaimedOrbit {
            periods: self.periods,
            impacts: self.impacts.iter().map(impact).collect::<Result<_, _>>()?,
            radii: [
                decimal(&self.phase_radius, "phase_radius")?,
                decimal(&self.speed_radius, "speed_radius")?,
            ],
            isolation: [
                decimal(&self.isolated_in_phase, "isolated_in_phase")?,
                decimal(&self.isolated_in_speed, "isolated_in_speed")?,
            ],
            stability: stability.unwrap_or(ClaimedStability { attracts: None, largest: None }),
        })
    }
}

/// Refuses a list that is longer than those of any certificate.
fn check_length<T>(list: &[T], key: &str) -> Result<(), JsonError> {
    match list.len() <= LONGEST_LIST {
        true => Ok(()),
        false => unexpected(key, "a list of at most 1000 entries"),
    }
}

impl OrbitCertificateDocument {
    /// The certificate that is written, with nothing checked but that it is one.
    ///
    /// # Errors
    /// A key that holds something else, or more than a certificate ever has.
    pub fn read(&self) -> Result<OrbitCertificate, JsonError> {
        check_kind(&self.schema, DocumentKind::Certificate)?;
        if self.ode != EQUATION_WITH_WALLS {
            return unexpected("ode", "the equation of a certificate of impact orbits");
        }
        check_length(&self.walls, "walls")?;
        check_length(&self.orbits, "orbits")?;
        Ok(OrbitCertificate {
            oscillator: WalledOscillator {
                damping: fraction(&self.c, "c")?,
                stiffness: fraction(&self.k, "k")?,
                frequency: fraction(&self.driving_frequency, "driving_frequency")?,
                load: self.load.read("load")?,
                walls: self.walls.iter().map(CertificateWall::read).collect::<Result<_, _>>()?,
            },
            bits: self.bits,
            orbits: self.orbits.iter().map(CertificateOrbit::read).collect::<Result<_, _>>()?,
        })
    }
}

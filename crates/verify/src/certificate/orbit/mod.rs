//! Certificates of periodic impact orbits: a linear driven oscillator between rigid walls.
//!
//! ```text
//! x'' + c x' + k x = p + a cos(omega t) + b sin(omega t)      off the walls
//! x' -> -e x'                                                 relative to a wall, at it
//! ```
//!
//! In: coefficients that are exact, and phases and speeds of the impacts of an orbit, however found. Out:
//! a proof that exactly one orbit with impacts on these walls in this order is within radii of them
//! (`krawczyk.rs`), that it touches no wall between its impacts (`admissible.rs`), and enclosures of its
//! Floquet multipliers, which decide its stability. All of it rests on `flow.rs`, the motion of a linear
//! oscillator in balls, and `equations.rs`.
//!
//! Source for the saltation matrix: P. C. Muller: Calculation of Lyapunov exponents for dynamic systems with
//! discontinuities, Chaos, Solitons and Fractals 5 (1995), 1671-1681.

mod admissible;
mod equations;
mod flow;
mod krawczyk;

use std::collections::BTreeSet;

use num_traits::Signed as _;

use self::equations::{Flight, GapEquations, ImpactBalls};
use self::flow::{LinearFlow, product};
use self::krawczyk::{NewtonStep, Radii, widened};
use super::damped::{ClaimedStability, Multipliers};
use super::formula::Enclosure;
use super::fourier_series::WORKING;
use super::{CheckError, MOST_BITS};
use crate::decimal::neighbours;
use crate::exact::ball::{Ball, Balls};
use crate::exact::bound::Bound;
use crate::exact::rational::from_f64;
use crate::exact::{Integer, Rational};

/// The largest number of periods of the drive in an orbit of a certificate.
const MOST_PERIODS: u32 = 100;

/// The largest number of impacts of an orbit of a certificate.
const MOST_IMPACTS: usize = 40;

/// The largest number of orbits in a certificate.
const MOST_ORBITS: usize = 200;

/// Binary digits of the phases and speeds that [`certify_orbit`] writes.
const DIGITS: usize = 128;

/// A speed below this, in the units of the equation, is none in so many digits.
const SLOWEST: f64 = 1e-27;

/// A constant and a wave of the drive, exact: `constant + cosine cos(omega t) + sine sin(omega t)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExactHarmonic {
    /// The constant.
    pub constant: Rational,
    /// The factor of the cosine.
    pub cosine: Rational,
    /// The factor of the sine.
    pub sine: Rational,
}

impl ExactHarmonic {
    /// Changes each of the three numbers in the same way.
    fn map(&self, change: impl Fn(&Rational) -> Rational) -> Self {
        let [constant, cosine, sine] = [&self.constant, &self.cosine, &self.sine].map(change);
        Self { constant, cosine, sine }
    }
}

/// A rigid wall, its numbers exact.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExactWall {
    /// Whether it bounds the motion from above, `x < place`; else from below, `x > place`.
    pub is_above: bool,
    /// The place.
    pub place: ExactHarmonic,
    /// The coefficient of restitution e, from 0 to 1.
    pub restitution: Rational,
}

/// A linear driven oscillator with walls, its numbers exact.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WalledOscillator {
    /// The damping c.
    pub damping: Rational,
    /// The stiffness k.
    pub stiffness: Rational,
    /// The frequency omega of the drive, positive.
    pub frequency: Rational,
    /// The right side of the equation.
    pub load: ExactHarmonic,
    /// One wall, or one on each side.
    pub walls: Vec<ExactWall>,
}

/// An impact of an orbit whose phase and speed are integers times `2^-bits` of the certificate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClaimedImpact {
    /// The index of the wall.
    pub wall: usize,
    /// The phase `omega t`, which grows from impact to impact.
    pub phase: Integer,
    /// The speed relative to the wall just before the impact.
    pub speed: Integer,
}

/// An orbit, and what is claimed of it.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimedOrbit {
    /// The periods of the drive in a period of the orbit.
    pub periods: u32,
    /// The approximate impacts in a period, in order of time.
    pub impacts: Vec<ClaimedImpact>,
    /// Claimed bounds of the distance of every phase, and of every speed, from these.
    pub radii: [Rational; 2],
    /// Distances of phases and of speeds within which no other orbit has its impacts.
    pub isolation: [Rational; 2],
    /// The stability that is claimed.
    pub stability: ClaimedStability,
}

/// Numbers from which periodic impact orbits can be proved. They may be anything: [`check_orbits`]
/// trusts none of them.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitCertificate {
    /// The oscillator and its walls.
    pub oscillator: WalledOscillator,
    /// Phases and speeds are integers times `2^-bits`.
    pub bits: usize,
    /// The orbits.
    pub orbits: Vec<ClaimedOrbit>,
}

/// An impact of a proved orbit.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct EnclosedImpact {
    /// The index of the wall.
    pub wall: usize,
    /// The phase `omega t`.
    pub phase: Enclosure,
    /// The speed relative to the wall just before the impact.
    pub speed: Enclosure,
}

/// A proved orbit: a motion that touches no wall but at its impacts.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CertifiedOrbit {
    /// The periods of the drive in a period of the orbit.
    pub periods: u32,
    /// Its impacts.
    pub impacts: Vec<EnclosedImpact>,
    /// Distances of all phases and of all speeds within which there is no other orbit of this kind.
    pub isolation: [Bound; 2],
    /// Its Floquet multipliers over a period of the orbit, and what they decide.
    pub multipliers: Multipliers,
}

/// The reason why an orbit is not proved. It says nothing about the orbit, but where that is said.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OrbitNotProved {
    /// No steady wave exists.
    #[error("without damping a drive at the natural frequency has no steady wave")]
    Resonance,
    /// A number is not exact.
    #[error("{what} is {value}, which is no fraction: a certificate needs to know it exactly")]
    NoFraction {
        /// The quantity.
        what: &'static str,
        /// Its value as it was written.
        value: String,
    },
    /// An impact may have no speed.
    #[error(
        "impact {impact} grazes the wall: its speed is not proved to be positive, and an orbit that grazes has no multipliers"
    )]
    Grazing {
        /// The number of the impact, from 1 on.
        impact: usize,
    },
    /// Impacts are not in order of time.
    #[error("impact {impact} is not proved to be later than the one before")]
    Order {
        /// The number of the impact, from 1 on.
        impact: usize,
    },
    /// The derivative may be singular.
    #[error(
        "the derivative of its equations may be singular: near a fold two orbits are too close to tell them apart"
    )]
    Singular,
    /// The orbit may lie elsewhere.
    #[error(
        "an orbit within these radii is not proved: the nearest one lies elsewhere, or farther"
    )]
    Missed,
    /// The motion may touch a wall between impacts.
    #[error(
        "between impacts it is not proved to stay off wall {}: it passes or touches that near the phase {}",
        .wall + 1, crate::decimal::decimal(*.phase)
    )]
    Touches {
        /// The index of the wall.
        wall: usize,
        /// The phase near which it may touch.
        phase: f64,
    },
    /// The digits do not suffice.
    #[error("the digits do not suffice: a number of the equation or of the orbit is too large")]
    Digits,
}

/// Whether every number of a ball is positive.
fn is_positive(ball: &Ball) -> bool {
    ball.middle.is_positive() && WORKING.distance_from_zero(ball) > 0.0
}

/// Proves an orbit near these impacts, each by the index of its wall, its phase and its speed just before
/// it; and makes the smallest claims that can be proved.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::{
///     ExactHarmonic, ExactWall, OrbitCertificate, WalledOscillator, certify_orbit, check_orbits,
/// };
/// use lindstedt::exact::Rational;
///
/// let number = |above: i64, below: i64| Rational::new(above.into(), below.into());
/// let harmonic = |constant, cosine| ExactHarmonic { constant, cosine, sine: number(0, 1) };
/// // x'' + x'/10 + x = cos(t) below the wall x = 1, restitution 4/5.
/// let wall = ExactWall {
///     is_above: true,
///     place: harmonic(number(1, 1), number(0, 1)),
///     restitution: number(4, 5),
/// };
/// let oscillator = WalledOscillator {
///     damping: number(1, 10),
///     stiffness: number(1, 1),
///     frequency: number(1, 1),
///     load: harmonic(number(0, 1), number(1, 1)),
///     walls: vec![wall],
/// };
/// let (orbit, proved) = certify_orbit(&oscillator, 1, &[(0, 0.076, 1.6957)])?;
/// assert_eq!(proved.multipliers.attracts, Some(true));
/// assert!(proved.impacts[0].speed.radius.value() < 1e-30);
/// let certificate = OrbitCertificate { oscillator, bits: OrbitCertificate::BITS, orbits: vec![orbit] };
/// assert_eq!(check_orbits(&certificate)?, [proved]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`OrbitNotProved`].
pub fn certify_orbit(
    oscillator: &WalledOscillator,
    periods: u32,
    impacts: &[(usize, f64, f64)],
) -> Result<(ClaimedOrbit, CertifiedOrbit), OrbitNotProved> {
    let equations = GapEquations::new(oscillator)?;
    let turn = turn(periods);
    let impact = |&(wall, phase, speed): &(usize, f64, f64)| {
        let exact = |value: f64| from_f64(value).map(|value| WORKING.fraction(&value));
        let [phase, speed] = [exact(phase)?, exact(speed)?].map(without_radius);
        Some(ImpactBalls { wall, phase, speed })
    };
    let near: Option<Vec<ImpactBalls>> = impacts.iter().map(impact).collect();
    let near = refined(&equations, near.ok_or(OrbitNotProved::Digits)?, &turn)?;
    let grazes = |own: &ImpactBalls| WORKING.nearest(&own.speed) <= SLOWEST;
    if let Some(index) = near.iter().position(grazes) {
        return Err(OrbitNotProved::Grazing { impact: index + 1 });
    }
    let newton = NewtonStep::new(&equations, &near, &turn)?;
    let radii = smallest_radii(&newton, &near)?;
    let slowest = near.iter().map(|own| WORKING.nearest(&own.speed)).fold(f64::MAX, f64::min);
    let short = |ball: &Ball| Balls { bits: DIGITS }.dyadic(&ball.middle, WORKING.bits).middle;
    let mut claimed = ClaimedOrbit {
        periods,
        impacts: near
            .iter()
            .map(|own| ClaimedImpact {
                wall: own.wall,
                phase: short(&own.phase),
                speed: short(&own.speed),
            })
            .collect(),
        isolation: isolation(&newton, slowest).unwrap_or_else(|| radii.clone()),
        radii,
        stability: ClaimedStability { attracts: None, largest: None },
    };
    let proved = prove(&equations, &claimed, DIGITS)?;
    claimed.stability = ClaimedStability::of(&proved.multipliers.stability());
    Ok((claimed, proved))
}

/// Proves every orbit of a certificate, and every claim.
///
/// # Errors
/// [`CheckError`].
pub fn check_orbits(certificate: &OrbitCertificate) -> Result<Vec<CertifiedOrbit>, CheckError> {
    certificate.well_formed().map_err(CheckError::Malformed)?;
    let equations = GapEquations::new(&certificate.oscillator)
        .map_err(|reason| CheckError::Orbit { orbit: 1, reason })?;
    let orbits = certificate.orbits.iter().enumerate().map(|(index, claimed)| {
        let proved = prove(&equations, claimed, certificate.bits)
            .map_err(|reason| CheckError::Orbit { orbit: index + 1, reason })?;
        claimed.stability.hold(Some(&proved.multipliers.stability()))?;
        Ok(proved)
    });
    orbits.collect()
}

impl OrbitCertificate {
    /// The binary digits of the phases and speeds that [`certify_orbit`] writes.
    pub const BITS: usize = DIGITS;

    /// Checks that sizes and numbers fit together; the error names what does not.
    fn well_formed(&self) -> Result<(), &'static str> {
        let WalledOscillator { frequency, walls, .. } = &self.oscillator;
        let one = Rational::from_integer(1.into());
        let is_restitution = |e: &Rational| !e.is_negative() && *e <= one;
        let sides: BTreeSet<bool> = walls.iter().map(|wall| wall.is_above).collect();
        let impacts = || self.orbits.iter().flat_map(|orbit| &orbit.impacts);
        let demands = [
            (self.bits <= MOST_BITS, "more than 224 bits"),
            (frequency.is_positive(), "a frequency that is not positive"),
            (!walls.is_empty(), "no wall"),
            (sides.len() == walls.len(), "two walls on one side"),
            (
                walls.iter().all(|wall| is_restitution(&wall.restitution)),
                "a coefficient of restitution that is not from 0 to 1",
            ),
            ((1..=MOST_ORBITS).contains(&self.orbits.len()), "no orbit, or more than 200"),
            (
                self.orbits.iter().all(|own| (1..=MOST_PERIODS).contains(&own.periods)),
                "an orbit of no period of the drive, or of more than 100",
            ),
            (
                self.orbits.iter().all(|own| (1..=MOST_IMPACTS).contains(&own.impacts.len())),
                "an orbit without an impact, or with more than 40",
            ),
            (impacts().all(|own| own.wall < walls.len()), "an impact on no wall"),
            (
                impacts().all(|own| own.phase.bits() <= 700 && own.speed.bits() <= 700),
                "a number of more than 200 digits",
            ),
        ];
        match demands.into_iter().find(|(holds, _)| !holds) {
            Some((_, reason)) => Err(reason),
            None => Ok(()),
        }
    }
}

/// The duration of so many periods of the drive, `2 pi n` by phase.
fn turn(periods: u32) -> Ball {
    WORKING.scaled(&WORKING.pi(), 2 * i64::from(periods))
}

fn without_radius(ball: Ball) -> Ball {
    Ball { radius: Bound::ZERO, ..ball }
}

/// Impacts after Newton's iteration, without a proof, shortened to [`DIGITS`].
fn refined(
    equations: &GapEquations,
    mut impacts: Vec<ImpactBalls>,
    turn: &Ball,
) -> Result<Vec<ImpactBalls>, OrbitNotProved> {
    const STEPS: usize = 20;
    let enough = Bound::power_of_two(-(DIGITS as i32) - 30);
    for _ in 0..STEPS {
        let step = NewtonStep::new(equations, &impacts, turn)?.step;
        for (own, step) in impacts.iter_mut().zip(step.chunks_exact(2)) {
            own.phase = without_radius(WORKING.difference(&own.phase, &step[0]));
            own.speed = without_radius(WORKING.difference(&own.speed, &step[1]));
        }
        if step.iter().all(|ball| WORKING.size_of_middle(ball) < enough) {
            break;
        }
    }
    let short = Balls { bits: DIGITS };
    for ball in impacts.iter_mut().flat_map(|own| [&mut own.phase, &mut own.speed]) {
        *ball = WORKING.dyadic(&short.dyadic(&ball.middle, WORKING.bits).middle, DIGITS);
    }
    Ok(impacts)
}

/// The smallest radii that are proved, of phases and speeds, as short decimals.
fn smallest_radii(
    newton: &NewtonStep,
    impacts: &[ImpactBalls],
) -> Result<[Rational; 2], OrbitNotProved> {
    const STEPS: usize = 12;
    /// The significant digits of a claim.
    const SHORT: usize = 3;
    let size =
        impacts.iter().map(|own| WORKING.magnitude(&own.speed)).fold(Bound::ZERO, Bound::max);
    let start = Bound::power_of_two(-80);
    let mut radii = Radii { phase: start, speed: start * size };
    for _ in 0..STEPS {
        let proved = newton.within(radii)?;
        // Twice the radii that are proved are proved again.
        let next = Radii { phase: proved.phase + proved.phase, speed: proved.speed + proved.speed };
        let smaller = Radii { phase: next.phase + next.phase, speed: next.speed + next.speed };
        let settled = !(smaller.phase < radii.phase && smaller.speed < radii.speed);
        if next.phase < radii.phase && next.speed < radii.speed {
            radii = next;
        }
        if settled {
            break;
        }
    }
    let claim = |bound: Bound| {
        let value = from_f64(bound.value()).ok_or(OrbitNotProved::Digits)?;
        Ok(neighbours(&value, SHORT)[1].clone())
    };
    Ok([claim(radii.phase)?, claim(radii.speed)?])
}

/// Radii within which no other orbit has its impacts; of the speeds they are parts of the slowest. They are an eighth of the
/// largest that halvings find, so that a proof whose balls are somewhat wider holds as well.
fn isolation(newton: &NewtonStep, slowest: f64) -> Option<[Rational; 2]> {
    const MOST_HALVINGS: i32 = 60;
    const MARGIN: i32 = 3;
    let claims = |halvings: i32| {
        let part = 0.5_f64.powi(halvings);
        let claim = |value: f64| {
            let exact = from_f64(value).filter(|exact| exact.is_positive())?;
            Some(neighbours(&exact, 2)[0].clone())
        };
        Some([claim(part)?, claim(part * slowest)?])
    };
    let is_proved = |claims: &[Rational; 2]| newton.within(Radii::of(claims)).is_ok();
    let largest =
        (2..MOST_HALVINGS).find(|halvings| claims(*halvings).is_some_and(|own| is_proved(&own)))?;
    claims(largest + MARGIN).filter(is_proved)
}

/// Proves an orbit with its claims, but that of its stability.
fn prove(
    equations: &GapEquations,
    claimed: &ClaimedOrbit,
    bits: usize,
) -> Result<CertifiedOrbit, OrbitNotProved> {
    let turn = turn(claimed.periods);
    let impacts: Vec<ImpactBalls> = claimed
        .impacts
        .iter()
        .map(|own| ImpactBalls {
            wall: own.wall,
            phase: WORKING.dyadic(&own.phase, bits),
            speed: WORKING.dyadic(&own.speed, bits),
        })
        .collect();
    let newton = NewtonStep::new(equations, &impacts, &turn)?;
    let isolation = Radii::of(&claimed.isolation);
    newton.within(isolation)?;
    let proved = newton.within(Radii::of(&claimed.radii))?;
    let is_held = |proved: Bound, claim: &Rational| {
        from_f64(proved.value()).is_some_and(|proved| proved <= *claim)
    };
    let [phase, speed] = &claimed.radii;
    if !is_held(proved.phase, phase) || !is_held(proved.speed, speed) {
        return Err(OrbitNotProved::Missed);
    }
    let impacts = widened(&impacts, proved);
    if let Some(index) = impacts.iter().position(|own| !is_positive(&own.speed)) {
        return Err(OrbitNotProved::Grazing { impact: index + 1 });
    }
    let flights = equations.flights(&impacts, &turn)?;
    if let Some(flight) = flights.iter().find(|flight| !is_positive(&flight.duration)) {
        return Err(OrbitNotProved::Order { impact: flight.ends[1] + 1 });
    }
    for flight in &flights {
        admissible::stays_off_walls(equations, &impacts, flight)?;
    }
    let multipliers = multipliers(equations, &impacts, &flights, &turn)?;
    let enclosed = |own: &ImpactBalls| EnclosedImpact {
        wall: own.wall,
        phase: Enclosure::from_ball(&own.phase),
        speed: Enclosure::from_ball(&own.speed),
    };
    Ok(CertifiedOrbit {
        periods: claimed.periods,
        impacts: impacts.iter().map(enclosed).collect(),
        isolation: [isolation.phase, isolation.speed],
        multipliers,
    })
}

/// The multipliers over an orbit, from the trace of its monodromy matrix; their product is
/// `exp(-c T)` times the squares of the coefficients of restitution.
fn multipliers(
    equations: &GapEquations,
    impacts: &[ImpactBalls],
    flights: &[Flight],
    turn: &Ball,
) -> Result<Multipliers, OrbitNotProved> {
    // Without stiffness the velocity decays by `exp(-c t)`.
    let decay = LinearFlow { damping: equations.flow.damping.clone(), stiffness: Ball::zero() };
    let [_, [_, decay]] = decay.over(turn).ok_or(OrbitNotProved::Digits)?.matrix;
    let determinant = impacts.iter().fold(decay, |determinant, own| {
        let restitution = &equations.walls[own.wall].restitution;
        product(&determinant, &product(restitution, restitution))
    });
    let [[first, _], [_, last]] = equations.monodromy(impacts, flights)?;
    Ok(Multipliers::from_trace(&WORKING.sum(&first, &last), &determinant))
}

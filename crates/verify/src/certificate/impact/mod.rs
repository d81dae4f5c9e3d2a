//! The paper's impact, enclosed: a pendulum from rest against an elastic barrier, equation (9) with
//! any power n of the depth, or a sum of powers, its three phases with proved bounds.
//!
//! ```text
//! x'' + sin x + gamma (x - xc)^n H(x - xc) = 0,     x(0) = -A,  x'(0) = 0,     n = 3/2 in (9)
//! v^2 = 2 (cos xc - cos A)
//! t1 = K(k) + F(phi, k),     k = sin(A/2),   sin phi = sin(xc/2)/k
//! T = 2 t1 + (duration of the contact)
//! ```
//!
//! The force is not analytic where the contact begins, so that cosine series of a whole period
//! prove nothing; in each phase the energy is conserved, and two integrals remain (`elliptic.rs`,
//! `contact.rs`). In: numbers as fractions. Out: the characteristic numbers of an impact, each with
//! a bound of its error. It takes some 0.1 s.
//!
//! Source: equation (9) of the paper; for enclosures phase by phase see W. Tucker: Validated
//! Numerics, Princeton (2011).

mod contact;
mod elliptic;
mod lossy_contact;

use num_traits::{Signed as _, ToPrimitive as _, Zero as _};

use self::contact::{PowerLawContact, is_positive, position_and_waves, sine_and_cosine};
use self::lossy_contact::{LossLaw, LossyContact};
use super::Enclosure;
use super::fourier_series::WORKING;
use crate::exact::Rational;
use crate::exact::ball::Ball;
use crate::expr::{Expr, ExprError};
use crate::symbol::Symbol;

/// The proved enclosures of an impact; times in units of 1/omega, angles in rad.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ImpactEnclosure {
    /// Time from the release to the touch.
    pub time_to_contact: Enclosure,
    /// Speed at the touch.
    pub speed: Enclosure,
    /// The greatest depth.
    pub penetration: Enclosure,
    /// Duration of the contact.
    pub duration: Enclosure,
    /// Period from the release to the return.
    pub period: Enclosure,
    /// The restitution and the speed at the end of a contact that loses energy.
    pub loss: Option<LossEnclosure>,
}

/// The proved enclosures of what a contact leaves of the speed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LossEnclosure {
    /// The speed after the contact over that before.
    pub restitution: Enclosure,
    /// The speed after the contact.
    pub exit_speed: Enclosure,
}

impl ImpactEnclosure {
    /// The five numbers with their names, in the order of a report.
    pub fn in_order(&self) -> [(&'static str, &Enclosure); 5] {
        [
            ("time to contact", &self.time_to_contact),
            ("speed", &self.speed),
            ("penetration", &self.penetration),
            ("duration", &self.duration),
            ("period", &self.period),
        ]
    }

    /// The two numbers of the loss with their names, in the order of a report; `None` without loss.
    pub fn losses(&self) -> Option<[(&'static str, &Enclosure); 2]> {
        let LossEnclosure { restitution, exit_speed } = self.loss.as_ref()?;
        Some([("restitution", restitution), ("speed out", exit_speed)])
    }
}

/// The force `stiffness * d^exponent` of an elastic barrier, d the depth in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PowerLaw {
    /// The factor, positive.
    pub stiffness: Rational,
    /// The exponent, half of a positive whole number.
    pub exponent: Rational,
}

impl PowerLaw {
    /// The law of Hertz, with the exponent 3/2.
    pub fn hertz(stiffness: Rational) -> Self {
        Self { stiffness, exponent: Rational::new(3.into(), 2.into()) }
    }

    /// The power laws whose sum an expression in the depth and numbers is, each exponent once; `None` if it is
    /// no such sum.
    ///
    /// # Errors
    /// An expression that cannot be differentiated or written.
    ///
    /// ```
    /// # use lindstedt_verify as lindstedt;
    /// use lindstedt::certificate::PowerLaw;
    ///
    /// let laws = PowerLaw::sum_of(&"3*d^2/2 + 4*d^(3/2)".parse()?, "d".into())?.ok_or("no sum")?;
    /// let printed = |law: &PowerLaw| (law.stiffness.to_string(), law.exponent.to_string());
    /// let mut laws: Vec<_> = laws.iter().map(printed).collect();
    /// laws.sort();
    /// assert_eq!(laws, [("3/2".into(), "2".into()), ("4".into(), "3/2".into())]);
    /// assert_eq!(PowerLaw::sum_of(&"d + sin(d)".parse()?, "d".into())?, None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sum_of(force: &Expr, depth: Symbol) -> Result<Option<Vec<Self>>, ExprError> {
        force.expand()?.terms().iter().map(|term| Self::of(term, depth)).collect()
    }

    /// The power law that an expression in the depth and numbers is; `None` if it is another one.
    fn of(force: &Expr, depth: Symbol) -> Result<Option<Self>, ExprError> {
        let at_one = |expression: &Expr| expression.substitute(depth, &Expr::one())?.expand();
        let (stiffness, slope) = (at_one(force)?, at_one(&force.differentiate(depth)?)?);
        let (Some(stiffness), Some(slope)) = (stiffness.as_number(), slope.as_number()) else {
            return Ok(None);
        };
        if stiffness.is_zero() {
            return Ok(None);
        }
        let law = Self { stiffness: stiffness.clone(), exponent: slope / stiffness };
        // An exponent that is not written is that of no power, but a quotient of two sums.
        let exponent = Expr::number(law.exponent.clone());
        let Ok(power) = Expr::power(&Expr::from(depth), &exponent) else { return Ok(None) };
        let rest = (force - &(&Expr::number(law.stiffness.clone()) * &power)).expand()?;
        Ok(rest.is_zero().then_some(law))
    }

    /// p, two more than twice the exponent; `None` if the exponent is none that is proved.
    fn power(&self) -> Option<u32> {
        /// The largest p.
        const MOST: u32 = 42;
        let power = &self.exponent * Rational::from_integer(2.into());
        let power = power.is_integer().then(|| power.to_integer().to_u32()).flatten()? + 2;
        (3..=MOST).contains(&power).then_some(power)
    }
}

/// The reason why an impact is not enclosed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NotEnclosed {
    /// The release does not lead to a swing.
    #[error("the release -A must be a swing below the top: 0 < A < pi")]
    Release,
    /// The barrier is out of reach, or too far out.
    #[error("the barrier must be within reach and below the horizontal: -A < xc < A, |xc| < pi/2")]
    Barrier,
    /// The contact would gain energy.
    #[error("the damping lambda of the contact must not be negative")]
    Damping,
    /// There is no barrier.
    #[error("the stiffness gamma, the factor of a power of the depth, must be positive")]
    Stiffness,
    /// The force of the barrier is another power of the depth.
    #[error("the exponent of the depth must be half of a whole number, from 1/2 to 20")]
    Exponent,
    /// The contact goes deeper than the range in which its deepest point is known to be unique.
    #[error(
        "the contact goes on beyond the horizontal, x = pi/2: its deepest point is not proved to be the only one"
    )]
    Deep,
    /// The swing presses the motion against a barrier that has let go of it.
    #[error(
        "the swing may press the motion against the barrier again after that has let go: the end of the contact is not proved"
    )]
    PressedAgain,
    /// The digits do not suffice.
    #[error("the digits do not suffice: gamma is too small or too large for a proof")]
    Digits,
}

/// Encloses the impact of a pendulum that is released from rest at `-amplitude` towards a barrier
/// at `barrier`, on its right, whose force is the sum of these power laws.
///
/// A single one keeps two integrals; the contact with a sum is integrated as one that loses energy.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::{PowerLaw, enclose_impact};
/// use lindstedt::exact::Rational;
///
/// let fraction = |above: i64, below: i64| Rational::new(above.into(), below.into());
/// let barrier = PowerLaw::hertz(fraction(1_000_000, 1));
/// let impact = enclose_impact(&fraction(3, 2), &fraction(323, 1000), &[barrier])?;
/// assert!(impact.speed.radius.value() < 1e-30);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`NotEnclosed`] if there is no such impact, or its numbers are not proved.
pub fn enclose_impact(
    amplitude: &Rational,
    barrier: &Rational,
    force: &[PowerLaw],
) -> Result<ImpactEnclosure, NotEnclosed> {
    let approach = Approach::new(amplitude, barrier, force)?;
    let [(stiffness, power)] = approach.terms.as_slice() else {
        let none = Rational::from_integer(0.into());
        let integrated = enclose_lossy(amplitude, barrier, force, (&none, LossLaw::HuntCrossley))?;
        return Ok(ImpactEnclosure { loss: None, ..integrated });
    };
    let (stiffness, power) = (stiffness.clone(), *power);
    let Approach { place, waves, speed_squared, speed, time, .. } = approach;
    let contact = PowerLawContact { barrier: place, stiffness, power, speed_squared, waves };
    let qm = contact.root_of_depth()?;
    let duration = contact.duration(&qm)?;
    let period = WORKING.sum(&WORKING.scaled(&time, 2), &duration);
    Ok(ImpactEnclosure {
        time_to_contact: Enclosure::from_ball(&time),
        speed: Enclosure::from_ball(&speed),
        penetration: Enclosure::from_ball(&WORKING.product(&qm, &qm)),
        duration: Enclosure::from_ball(&duration),
        period: Enclosure::from_ball(&period),
        loss: None,
    })
}

/// Encloses the impact of a pendulum that is released from rest at `-amplitude` towards a barrier at `barrier`, on
/// its right, which loses energy by the law of Hunt and Crossley: its force is the sum of the power laws times
/// `1 + damping d'`. The period ends where the motion turns after the impact.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::{PowerLaw, enclose_lossy_impact};
/// use lindstedt::exact::Rational;
///
/// let fraction = |above: i64, below: i64| Rational::new(above.into(), below.into());
/// let barrier = PowerLaw::hertz(fraction(1_000_000, 1));
/// let impact = enclose_lossy_impact(&fraction(3, 2), &fraction(323, 1000), &[barrier], &fraction(1, 2))?;
/// assert!(impact.loss.is_some_and(|loss| loss.restitution.radius.value() < 1e-30));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`NotEnclosed`] if there is no such impact, or its numbers are not proved.
pub fn enclose_lossy_impact(
    amplitude: &Rational,
    barrier: &Rational,
    force: &[PowerLaw],
    damping: &Rational,
) -> Result<ImpactEnclosure, NotEnclosed> {
    enclose_lossy(amplitude, barrier, force, (damping, LossLaw::HuntCrossley))
}

/// Encloses the impact of a pendulum that is released from rest at `-amplitude` towards a barrier at `barrier`, on
/// its right, a spring with a dashpot: its force is `stiffness (d + damping d')`, which pulls before the depth is zero
/// again, where the contact ends; or one that does not pull, and lets go before. The period ends where the motion turns
/// after the impact.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::enclose_dashpot_impact;
/// use lindstedt::exact::Rational;
///
/// let fraction = |above: i64, below: i64| Rational::new(above.into(), below.into());
/// let (amplitude, barrier) = (fraction(3, 2), fraction(323, 1000));
/// for pulls in [true, false] {
///     let impact = enclose_dashpot_impact(&amplitude, &barrier, &fraction(1_000_000, 1), &fraction(1, 10_000), pulls)?;
///     assert!(impact.loss.is_some_and(|loss| loss.restitution.radius.value() < 1e-30));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`NotEnclosed`] if there is no such impact, or its numbers are not proved.
pub fn enclose_dashpot_impact(
    amplitude: &Rational,
    barrier: &Rational,
    stiffness: &Rational,
    damping: &Rational,
    pulls: bool,
) -> Result<ImpactEnclosure, NotEnclosed> {
    let spring =
        PowerLaw { stiffness: stiffness.clone(), exponent: Rational::from_integer(1.into()) };
    enclose_lossy(amplitude, barrier, &[spring], (damping, LossLaw::Dashpot { pulls }))
}

/// Encloses an impact with a loss by Hunt and Crossley, which may be zero, or by a dashpot.
fn enclose_lossy(
    amplitude: &Rational,
    barrier: &Rational,
    force: &[PowerLaw],
    (damping, law): (&Rational, LossLaw),
) -> Result<ImpactEnclosure, NotEnclosed> {
    if damping.is_negative() {
        return Err(NotEnclosed::Damping);
    }
    let approach = Approach::new(amplitude, barrier, force)?;
    let Approach { place, waves, speed, time, terms, .. } = approach;
    let contact = LossyContact {
        barrier: place,
        terms,
        damping: WORKING.fraction(damping),
        law,
        speed: speed.clone(),
    };
    let ends = contact.follow()?;
    // The motion turns where cos A = cos xc - v^2/2.
    let left = WORKING.divided(&WORKING.product(&ends.exit_speed, &ends.exit_speed), 2);
    let cosine = WORKING.difference(&waves[1], &left);
    let half = |square: Ball| WORKING.root(&WORKING.divided(&square, 2), 2);
    let one = WORKING.integer(1);
    let waves =
        || Some([half(WORKING.difference(&one, &cosine))?, half(WORKING.sum(&one, &cosine))?]);
    let back = || flight(waves()?, barrier);
    let back = back().ok_or(NotEnclosed::Digits)?;
    let period = WORKING.sum(&WORKING.sum(&time, &ends.duration), &back);
    let restitution = WORKING.quotient(&ends.exit_speed, &speed).ok_or(NotEnclosed::Digits)?;
    let depth = WORKING.product(&ends.root_of_depth, &ends.root_of_depth);
    Ok(ImpactEnclosure {
        time_to_contact: Enclosure::from_ball(&time),
        speed: Enclosure::from_ball(&speed),
        penetration: Enclosure::from_ball(&depth),
        duration: Enclosure::from_ball(&ends.duration),
        period: Enclosure::from_ball(&period),
        loss: Some(LossEnclosure {
            restitution: Enclosure::from_ball(&restitution),
            exit_speed: Enclosure::from_ball(&ends.exit_speed),
        }),
    })
}

/// The swing from the release to the touch.
struct Approach {
    /// Place of the barrier.
    place: Ball,
    /// Sine and cosine of the place.
    waves: [Ball; 2],
    speed_squared: Ball,
    speed: Ball,
    /// The time to the touch.
    time: Ball,
    /// gamma and p of each power law of the barrier.
    terms: Vec<(Ball, u32)>,
}

impl Approach {
    fn new(
        amplitude: &Rational,
        barrier: &Rational,
        force: &[PowerLaw],
    ) -> Result<Self, NotEnclosed> {
        if force.is_empty() || !force.iter().all(|law| law.stiffness.is_positive()) {
            return Err(NotEnclosed::Stiffness);
        }
        let term = |law: &PowerLaw| Some((WORKING.fraction(&law.stiffness), law.power()?));
        let terms = force.iter().map(term).collect::<Option<_>>().ok_or(NotEnclosed::Exponent)?;
        let (pi, release) = (WORKING.pi(), WORKING.fraction(amplitude));
        if !amplitude.is_positive() || !is_positive(&WORKING.difference(&pi, &release)) {
            return Err(NotEnclosed::Release);
        }
        let twice = WORKING.fraction(&(barrier.abs() * Rational::from_integer(2.into())));
        let horizontal = is_positive(&WORKING.difference(&pi, &twice));
        if barrier.abs() >= *amplitude || !horizontal {
            return Err(NotEnclosed::Barrier);
        }
        let (place, waves) = position_and_waves(barrier).ok_or(NotEnclosed::Digits)?;
        let [_, cosine] = sine_and_cosine(&release).ok_or(NotEnclosed::Digits)?;
        let speed_squared = WORKING.scaled(&WORKING.difference(&waves[1], &cosine), 2);
        let speed = WORKING.root(&speed_squared, 2).ok_or(NotEnclosed::Digits)?;
        let half = sine_and_cosine(&WORKING.divided(&release, 2));
        let time = half.and_then(|half| flight(half, barrier)).ok_or(NotEnclosed::Digits)?;
        Ok(Self { place, waves, speed_squared, speed, time, terms })
    }
}

/// The time from rest at `-A` to `place`, with the sine and the cosine of `A/2`.
fn flight([modulus, cosine]: [Ball; 2], place: &Rational) -> Option<Ball> {
    let half = WORKING.fraction(&(place * Rational::new(1.into(), 2.into())));
    let [sine, cosine_there] = sine_and_cosine(&half)?;
    let (one, squared) = (WORKING.integer(1), |ball: &Ball| WORKING.product(ball, ball));
    let quarter = elliptic::carlson_rf(&Ball::zero(), &squared(&cosine), &one)?;
    let sine = WORKING.quotient(&sine, &modulus)?;
    let rest = WORKING.difference(&one, &squared(&sine));
    let beyond = elliptic::carlson_rf(&rest, &squared(&cosine_there), &one)?;
    Some(WORKING.sum(&quarter, &WORKING.product(&sine, &beyond)))
}

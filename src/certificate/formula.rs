//! What a proved motion says about a formula: how far it is off, from both sides.
//!
//! ```text
//! x~(t) = X~(omega~ t),   D(theta) = Xbar(theta) - X~(theta), a series of degree K;   theta_j = pi j/M
//! max_j |D(theta_j)| - r <= max |X - X~| <= max_j |D(theta_j)|/cos(K pi/(2 M)) + r
//! |x(t) - x~(t)| <= max |X - X~| + max |X~'| |omega - omega~| |t|
//! ```
//!
//! In: a certificate and its proof. Out: enclosures, as doubles rounded outwards. The cost is K M products.
//!
//! Source: H. Ehlich, K. Zeller: Schwankung von Polynomen zwischen Gitterpunkten, Mathematische Zeitschrift 86 (1964), 41-44.

use std::f64::consts::PI;

use num_traits::Zero as _;

use super::fourier_series::{FourierSeries, WORKING, sum_of_angles};
use super::radii_polynomial::{NotProved, Proof};
use super::{Certificate, Certified, CheckError};
use crate::exact::ball::{Ball, Balls};
use crate::exact::bound::Bound;
use crate::exact::rational::from_f64;
use crate::exact::{Integer, Rational};

/// A number with everything that it may be.
#[derive(Clone, Debug, PartialEq)]
pub struct Enclosure {
    /// The middle.
    pub middle: Rational,
    /// How far the number may be from it.
    pub radius: Bound,
}

impl Enclosure {
    pub(super) fn of(ball: &Ball) -> Self {
        Self {
            middle: WORKING.middle(ball),
            radius: ball.radius,
        }
    }

    /// The relative error of a number that stands for what is enclosed, `|number/truth - 1|`; all that is known where it is no number.
    pub fn relative_error(&self, number: f64) -> Range {
        let Some(exact) = from_f64(number) else {
            return Range {
                lower: 0.0,
                upper: f64::INFINITY,
            };
        };
        let (truth, radius) = (Bound::of_fraction(&self.middle), self.radius);
        let apart = Bound::of_fraction(&(exact - &self.middle));
        let (closest, farthest) = ((below(apart) - radius.value()).next_down().max(0.0), apart + radius);
        Range {
            lower: (closest / (truth + radius).value()).next_down().max(0.0),
            upper: farthest.over((below(truth) - radius.value()).next_down()).value(),
        }
    }
}

/// No more than a size whose bound this is, rounded up from the nearest double.
const fn below(bound: Bound) -> f64 {
    bound.value().next_down().next_down()
}

/// The ends between which a size is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Range {
    /// No less.
    pub lower: f64,
    /// No more.
    pub upper: f64,
}

/// A formula with numbers, and what is claimed of it.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedFormula {
    /// The law, in words of whoever derived it.
    pub law: String,
    /// The angular frequency, an integer times `2^-bits` of the certificate.
    pub frequency: Integer,
    /// The cosine coefficients of the motion, likewise.
    pub coefficients: Vec<Integer>,
    /// Its sine coefficients by harmonic, likewise; none of a motion that begins at rest.
    pub sines: Vec<Integer>,
    /// What is claimed of `max |X - X~|`.
    pub deviation: [Rational; 2],
    /// What is claimed of `|omega - omega~|`.
    pub frequency_error: [Rational; 2],
    /// What is claimed of `max |X~'| |omega - omega~|`, by which the two motions part at most in a unit of time.
    pub drift: [Rational; 2],
    /// Of a driven motion, what is claimed of `|a - a~|`; zeros of others.
    pub amplitude_error: [Rational; 2],
}

/// How far a formula is off.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Errors {
    /// `max |X - X~|`, both at the same phase, in the unit of the coordinate.
    pub deviation: Range,
    /// `|omega - omega~|`.
    pub frequency: Range,
    /// `|omega~/omega - 1|`; of a driven motion, whose frequency is known, `|a~/a - 1|`.
    pub relative: Range,
    /// `max |X~'| |omega - omega~|`: what is added to the deviation at most in a unit of time.
    pub drift: Range,
    /// Of a driven motion `|a - a~|`, the amplitudes of its own harmonic.
    pub amplitude: Option<Range>,
}

impl JudgedFormula {
    /// The frequency, of units of `2^-bits`.
    pub(super) fn frequency_ball(&self, bits: usize) -> Ball {
        WORKING.dyadic(&self.frequency, bits)
    }

    /// The motion, likewise.
    pub(super) fn motion(&self, bits: usize) -> FourierSeries {
        let balls = |units: &[Integer]| units.iter().map(|units| WORKING.dyadic(units, bits)).collect();
        FourierSeries::exactly(balls(&self.coefficients), balls(&self.sines))
    }
}

/// A motion that is proved, against which a formula is held.
pub(super) struct Truth<'a> {
    /// The approximate motion.
    pub(super) motion: &'a FourierSeries,
    /// omega.
    pub(super) frequency: &'a Ball,
    /// The true motion is so near.
    pub(super) radius: Bound,
}

/// What follows from a proof.
///
/// # Errors
/// A frequency without a value.
pub(super) fn certified(certificate: &Certificate, proof: Proof) -> Result<Certified, NotProved> {
    let mut mu = certificate.mu_ball();
    mu.radius += proof.radius.over(Bound::power_of_two(certificate.sigma).value());
    let inverse = WORKING.quotient(&WORKING.integer(1), &mu);
    let frequency = inverse.and_then(|inverse| WORKING.root(&inverse, 2));
    let frequency = frequency.ok_or(NotProved::TooLarge(proof.radius))?;
    let motion = certificate.motion();
    let truth = Truth {
        motion: &motion,
        frequency: &frequency,
        radius: proof.radius,
    };
    let bits = certificate.bits;
    let errors = |formula: &JudgedFormula| truth.errors(&formula.frequency_ball(bits), &formula.motion(bits));
    Ok(Certified {
        proof,
        frequency: Enclosure::of(&frequency),
        exponent: None,
        amplitude: None,
        formula: certificate.formula.as_ref().map(errors),
    })
}

impl Truth<'_> {
    /// `max |X - X~|`.
    fn deviation(&self, own_motion: &FourierSeries) -> Range {
        let (lower, upper) = largest(&self.motion.difference(own_motion));
        Range {
            lower: (lower - self.radius.value()).next_down().max(0.0),
            upper: (upper + self.radius).value(),
        }
    }

    /// How far a formula of this motion is off, whose frequency is that of the drive; the amplitudes are that of the formula and the true one.
    pub(super) fn errors_of_driven(&self, own_motion: &FourierSeries, [own, truth]: [&Ball; 2]) -> Errors {
        let (amplitude, relative) = apart(own, truth);
        Errors {
            deviation: self.deviation(own_motion),
            frequency: Range::default(),
            relative,
            drift: Range::default(),
            amplitude: Some(amplitude),
        }
    }

    /// How far a formula of this frequency and motion is off.
    pub(super) fn errors(&self, own_frequency: &Ball, own_motion: &FourierSeries) -> Errors {
        let (frequency_error, relative) = apart(own_frequency, self.frequency);
        let (flattest, steepest) = largest(&own_motion.derivative());
        Errors {
            deviation: self.deviation(own_motion),
            relative,
            amplitude: None,
            drift: Range {
                lower: (flattest * frequency_error.lower).next_down().max(0.0),
                upper: (steepest * Bound::exactly(frequency_error.upper)).value(),
            },
            frequency: frequency_error,
        }
    }
}

/// How far a number is from the true one, and that over the true one.
fn apart(own: &Ball, truth: &Ball) -> (Range, Range) {
    let off = WORKING.difference(own, truth);
    let error = Range {
        lower: WORKING.distance_from_zero(&off).max(0.0),
        upper: WORKING.magnitude(&off).value(),
    };
    let smallest = WORKING.distance_from_zero(truth);
    let relative = Range {
        lower: (error.lower / WORKING.magnitude(truth).value()).next_down().max(0.0),
        upper: match smallest > 0.0 {
            true => Bound::exactly(error.upper).over(smallest).value(),
            false => f64::INFINITY,
        },
    };
    (error, relative)
}

/// The largest size of a series, from below and from above.
fn largest(series: &FourierSeries) -> (f64, Bound) {
    const BALLS: Balls = Balls { bits: 80 };
    let degree = series.length();
    let parts = [&series.cosines, &series.sines];
    let empty = parts.map(|balls| balls.iter().all(Ball::is_zero));
    if empty == [true, true] {
        return (0.0, series.tail);
    }
    let points = (64 * degree).min(4096).max(16 * degree);
    let table = waves(points, BALLS);
    // Of an even or odd function half a turn is enough.
    let all = match empty == [false, false] {
        true => 2 * points,
        false => points + 1,
    };
    let short = parts.map(|balls| {
        balls
            .iter()
            .map(|ball| BALLS.converted(ball, WORKING))
            .collect::<Vec<Ball>>()
    });
    let (mut lower, mut upper) = (0.0_f64, Bound::ZERO);
    for j in 0..all {
        let (mut units, mut radius) = (Integer::zero(), Bound::ZERO);
        for (wave, coefficients) in short.iter().enumerate() {
            for (k, coefficient) in coefficients.iter().enumerate().filter(|(_, ball)| !ball.is_zero()) {
                let value = &table[j * k % (2 * points)][wave];
                units += &coefficient.middle * &value.middle;
                radius += BALLS.radius_of_product(coefficient, value);
            }
        }
        let value = BALLS.rounded(&units, radius);
        lower = lower.max(BALLS.distance_from_zero(&value));
        upper = upper.max(BALLS.magnitude(&value));
    }
    // cos y >= 1 - y^2/2.
    let half_step = Bound::of_nearest(PI) * Bound::exactly(degree as f64) / (2 * points as u32);
    let between = (half_step * half_step / 2).below_complement();
    (
        (lower - series.tail.value()).next_down().max(0.0),
        upper.over(between) + series.tail,
    )
}

/// Cosine and sine of the angles `pi j/points`, `j` below twice their number.
fn waves(points: usize, balls: Balls) -> Vec<[Ball; 2]> {
    let step = WORKING.divided(&WORKING.pi(), u32::try_from(points).unwrap_or(u32::MAX));
    let unknown = || {
        let all = FourierSeries::exactly(vec![], vec![]).widened(Bound::exactly(1.0));
        (all.clone(), all)
    };
    let (sine, cosine) = FourierSeries::constant(step).sine_and_cosine().unwrap_or_else(unknown);
    let turn = [cosine.at_zero(), sine.at_zero()];
    let mut at = [WORKING.integer(1), Ball::zero()];
    let mut table = Vec::with_capacity(2 * points);
    for _ in 0..2 * points {
        table.push(at.each_ref().map(|value| balls.converted(value, WORKING)));
        at = sum_of_angles(&at, &turn);
    }
    table
}

/// Whether everything claimed is proved.
///
/// # Errors
/// The first claim that is not.
pub(super) fn hold_claims(
    radius: &Rational,
    formula: Option<&JudgedFormula>,
    certified: &Certified,
) -> Result<(), CheckError> {
    let above = |what, proved, claim: &Rational| match from_f64(proved).is_some_and(|proved| proved <= *claim) {
        true => Ok(()),
        false => Err(CheckError::ClaimedLess { what, proved }),
    };
    let below = |what, proved, claim: &Rational| match from_f64(proved).is_some_and(|proved| *claim <= proved) {
        true => Ok(()),
        false => Err(CheckError::ClaimedMore { what, proved }),
    };
    above("the radius", certified.proof.radius.value(), radius)?;
    if let (Some(claimed), Some(errors)) = (formula, &certified.formula) {
        let amplitude = errors.amplitude.unwrap_or_default();
        let both = [
            ("the error of the amplitude", amplitude, &claimed.amplitude_error),
            ("the deviation", errors.deviation, &claimed.deviation),
            ("the error of the frequency", errors.frequency, &claimed.frequency_error),
            ("the drift", errors.drift, &claimed.drift),
        ];
        for (what, proved, claim) in both {
            below(what, proved.lower, &claim[0])?;
            above(what, proved.upper, &claim[1])?;
        }
    }
    Ok(())
}

//! Bounds from both sides of the error of a formula, from the proved motion.
//!
//! ```text
//! x~(t) = X~(omega~ t),   D(theta) = Xbar(theta) - X~(theta), a series of degree K;   theta_j = pi j/M
//! max_j |D(theta_j)| - r <= max |X - X~| <= max_j |D(theta_j)|/cos(K pi/(2 M)) + r
//! |x(t) - x~(t)| <= max |X - X~| + max |X~'| |omega - omega~| |t|
//! ```
//!
//! In: a certificate and its proof. Out: enclosures, as doubles rounded outwards. The cost is K M
//! products.
//!
//! Source: H. Ehlich, K. Zeller: Schwankung von Polynomen zwischen Gitterpunkten, Mathematische
//! Zeitschrift 86 (1964), 41-44.

use std::f64::consts::PI;

use num_traits::{Signed as _, Zero as _};

use super::elementary::Analytic as _;
use super::fourier_series::{FourierSeries, WORKING, sum_of_angles};
use super::law;
use super::radii_polynomial::{NotProved, Proof};
use super::{Certified, CheckError, HIGHEST_HARMONIC};
use crate::exact::ball::{Ball, Balls};
use crate::exact::ball_products::{BallFactor, BallProductSums};
use crate::exact::bound::Bound;
use crate::exact::rational::from_f64;
use crate::exact::{Integer, Rational};
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FIRST_HARMONIC, FREQUENCY, may_stand_for};
use crate::values::Values;

/// An interval that contains a number, as middle and radius.
#[derive(Clone, Debug, PartialEq)]
pub struct Enclosure {
    /// The middle.
    pub middle: Rational,
    /// Bound of the distance of the number from the middle.
    pub radius: Bound,
}

impl Enclosure {
    pub(super) fn from_ball(ball: &Ball) -> Self {
        Self { middle: WORKING.middle(ball), radius: ball.radius }
    }

    /// Bounds of the absolute value of the enclosed number.
    pub(super) fn size(&self) -> SizeBounds {
        let middle = Bound::of_fraction(&self.middle);
        SizeBounds {
            lower: (below(middle) - self.radius.value()).next_down().max(0.0),
            upper: (middle + self.radius).value(),
        }
    }

    /// Bounds of the relative error `|number/truth - 1|` of an approximation to the enclosed
    /// number; from zero to infinity if it is not finite.
    pub fn relative_error(&self, number: f64) -> SizeBounds {
        let Some(exact) = from_f64(number) else {
            return SizeBounds { lower: 0.0, upper: f64::INFINITY };
        };
        let (truth, radius) = (Bound::of_fraction(&self.middle), self.radius);
        let apart = Bound::of_fraction(&(exact - &self.middle));
        let (closest, farthest) =
            ((below(apart) - radius.value()).next_down().max(0.0), apart + radius);
        SizeBounds {
            lower: (closest / (truth + radius).value()).next_down().max(0.0),
            upper: farthest.over((below(truth) - radius.value()).next_down()).value(),
        }
    }
}

/// A lower bound of a size whose bound was rounded up from the nearest double.
const fn below(bound: Bound) -> f64 {
    bound.value().next_down().next_down()
}

/// The ends between which a size is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SizeBounds {
    /// The lower bound.
    pub lower: f64,
    /// The upper bound.
    pub upper: f64,
}

/// The symbols of amplitude and frequency in a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LettersOfLaw {
    /// The initial amplitude, `A` unless the equation uses that name.
    pub amplitude: Symbol,
    /// The frequency, `omega` unless the equation uses that name.
    pub frequency: Symbol,
}

impl LettersOfLaw {
    /// The symbols of these names; `None` if no answer uses such names.
    pub fn of_names(amplitude: &str, frequency: &str) -> Option<Self> {
        let taken = [(amplitude, AMPLITUDE), (frequency, FREQUENCY)];
        let belongs = taken.iter().all(|(name, usual)| may_stand_for(name, *usual))
            || may_stand_for(amplitude, FIRST_HARMONIC) && may_stand_for(frequency, FREQUENCY);
        belongs
            .then(|| Self { amplitude: Symbol::new(amplitude), frequency: Symbol::new(frequency) })
    }

    /// The symbols that are in force on this thread.
    pub(super) fn in_force() -> Self {
        let written = |usual: Symbol| Symbol::new(usual.written());
        Self { amplitude: written(AMPLITUDE), frequency: written(FREQUENCY) }
    }
}

impl Default for LettersOfLaw {
    fn default() -> Self {
        Self { amplitude: AMPLITUDE, frequency: FREQUENCY }
    }
}

/// A formula with numbers, and what is claimed of it.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedFormula {
    /// The law as it was derived: `omega = ...` or `omega^2 = ...`, of a driven motion `x = ...` in
    /// t, with definitions of symbols after commas. A text of another form counts as words, and
    /// nothing is proved of it.
    pub law: String,
    /// The symbols of amplitude and frequency in the law.
    pub letters: LettersOfLaw,
    /// The values of the symbols in the law.
    pub values: Values,
    /// The angular frequency, an integer times `2^-bits` of the certificate.
    pub frequency: Integer,
    /// The cosine coefficients of the motion, in the same unit.
    pub coefficients: Vec<Integer>,
    /// The cosine coefficients of every coordinate but the first, in the same unit; empty for one
    /// coordinate.
    pub others: Vec<Vec<Integer>>,
    /// The sine coefficients by harmonic, in the same unit; empty for a motion that begins at rest.
    pub sines: Vec<Integer>,
    /// Claimed lower and upper bound of `max |X - X~|`.
    pub deviation: [Rational; 2],
    /// Claimed bounds of `|omega - omega~|`.
    pub frequency_error: [Rational; 2],
    /// Claimed bounds of `max |X~'| |omega - omega~|`, the largest rate at which the two motions
    /// drift apart.
    pub drift: [Rational; 2],
    /// Claimed bounds of `|a - a~|` for a driven motion; zeros for others.
    pub amplitude_error: [Rational; 2],
}

/// Errors of a formula, each between two bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Errors {
    /// `max |X - X~|`, both at the same phase, in the unit of the coordinate; of the nearest of the
    /// [copies](Certified::copies) of X, and of several coordinates the largest.
    pub deviation: SizeBounds,
    /// `|omega - omega~|`.
    pub frequency: SizeBounds,
    /// `|omega~/omega - 1|`; of a driven motion, whose frequency is known, `|a~/a - 1|`.
    pub relative: SizeBounds,
    /// `max |X~'| |omega - omega~|`, the largest growth of the deviation per unit of time.
    pub drift: SizeBounds,
    /// `|a - a~|` for a driven motion, the amplitudes of its own harmonic.
    pub amplitude: Option<SizeBounds>,
}

impl JudgedFormula {
    /// Checks sizes, and of a motion without a drive that the frequency is positive and the first
    /// harmonic there: with another sign, or as that of half the frequency, the same formula would
    /// be compared with the motion at another phase.
    pub(super) fn well_formed(&self, is_driven: bool) -> Result<(), &'static str> {
        let small = |integer: &Integer| integer.bits() <= 700;
        let lists = || [&self.coefficients, &self.sines].into_iter().chain(&self.others);
        let mut first = lists().map(|list| list.get(1).is_some_and(|first| !first.is_zero()));
        let demands = [
            (
                lists().all(|list| list.len() <= 2 * HIGHEST_HARMONIC),
                "a formula of more than 800 harmonics",
            ),
            (
                lists().flatten().chain([&self.frequency]).all(small),
                "a formula with a number of more than 200 digits",
            ),
            (
                is_driven || self.frequency.is_positive(),
                "a formula whose frequency is not positive",
            ),
            (is_driven || first.any(|is_there| is_there), "a formula without a first harmonic"),
        ];
        match demands.into_iter().find(|(holds, _)| !holds) {
            Some((_, reason)) => Err(reason),
            None => Ok(()),
        }
    }

    /// The frequency, stored in units of `2^-bits`.
    pub(super) fn frequency_ball(&self, bits: usize) -> Ball {
        WORKING.dyadic(&self.frequency, bits)
    }

    /// The motions of all coordinates, stored in units of `2^-bits`.
    pub(super) fn motions(&self, bits: usize) -> Vec<FourierSeries> {
        let balls =
            |units: &Vec<Integer>| units.iter().map(|units| WORKING.dyadic(units, bits)).collect();
        let others = self.others.iter().map(|list| FourierSeries::exactly(balls(list), vec![]));
        std::iter::once(self.motion(bits)).chain(others).collect()
    }

    /// The motion of the first coordinate, stored in units of `2^-bits`.
    pub(super) fn motion(&self, bits: usize) -> FourierSeries {
        let balls =
            |units: &[Integer]| units.iter().map(|units| WORKING.dyadic(units, bits)).collect();
        FourierSeries::exactly(balls(&self.coefficients), balls(&self.sines))
    }
}

/// A proved motion, with which a formula is compared.
pub(super) struct Truth<'a> {
    /// The approximate motion, and its images under the symmetries of its equation: a formula
    /// describes all of them.
    pub(super) copies: &'a [FourierSeries],
    /// omega.
    pub(super) frequency: &'a Ball,
    /// The distance of the true motion from the approximate one, and of each image likewise.
    pub(super) radius: Bound,
}

/// Returns the frequency and the errors of the formula that follow from a proof: of `1/omega^2` and
/// its weight, and of the approximate motions of all coordinates. The errors of the motion are the
/// largest of those of the coordinates.
///
/// # Errors
/// A frequency without a value.
pub(super) fn certified(
    (mut mu, sigma): (Ball, i32),
    motions: &[FourierSeries],
    bits: usize,
    formula: Option<&JudgedFormula>,
    proof: Proof,
) -> Result<Certified, NotProved> {
    mu.radius += proof.radius.over(Bound::power_of_two(sigma).value());
    let inverse = WORKING.quotient(&WORKING.integer(1), &mu);
    let frequency = inverse.and_then(|inverse| WORKING.root(&inverse, 2));
    let frequency = frequency.ok_or(NotProved::TooLarge(proof.radius))?;
    let errors = |formula: &JudgedFormula| {
        let own_motions = formula.motions(bits);
        let pairs = motions.iter().zip(&own_motions);
        let errors = pairs.map(|(motion, own_motion)| {
            let copies = std::slice::from_ref(motion);
            let truth = Truth { copies, frequency: &frequency, radius: proof.radius };
            truth.errors(&formula.frequency_ball(bits), own_motion)
        });
        errors.reduce(Errors::of_both)
    };
    Ok(Certified {
        proof,
        frequency: Enclosure::from_ball(&frequency),
        exponent: None,
        multipliers: None,
        stability: None,
        amplitude: None,
        amplitudes: vec![],
        copies: 1,
        law_is_held: formula
            .is_some_and(|formula| law::law_matches_frequency(formula, bits) == Ok(true)),
        formula: formula.and_then(errors),
    })
}

impl SizeBounds {
    /// The bounds of the larger one of two sizes.
    const fn larger(self, other: Self) -> Self {
        Self { lower: self.lower.max(other.lower), upper: self.upper.max(other.upper) }
    }
}

impl Errors {
    /// The errors of the motions of two coordinates together, at one frequency.
    const fn of_both(self, other: Self) -> Self {
        Self {
            deviation: self.deviation.larger(other.deviation),
            drift: self.drift.larger(other.drift),
            ..self
        }
    }
}

impl Truth<'_> {
    /// `max |X - X~|` of the nearest copy.
    fn deviation(&self, own_motion: &FourierSeries) -> SizeBounds {
        let apart = |copy: &FourierSeries| {
            let difference = copy.difference(own_motion);
            (below_mean(&difference), difference)
        };
        let mut differences: Vec<(f64, FourierSeries)> = self.copies.iter().map(apart).collect();
        differences.sort_by(|one, other| one.0.total_cmp(&other.0));
        let (mut lower, mut upper) = (f64::INFINITY, Bound::UNKNOWN);
        for (mean, difference) in &differences {
            // The largest value is at least the root mean square: this copy and the following ones
            // are no nearer.
            if *mean >= upper.value() {
                break;
            }
            let (below, above) = largest(difference);
            lower = lower.min(below);
            upper = if above < upper { above } else { upper };
        }
        SizeBounds {
            lower: (lower - self.radius.value()).next_down().max(0.0),
            upper: (upper + self.radius).value(),
        }
    }

    /// Errors of a formula of a driven motion, whose frequency is that of the drive. The last
    /// argument holds the amplitude by the formula and the true one.
    pub(super) fn errors_of_driven(
        &self,
        own_motion: &FourierSeries,
        [own, truth]: [&Ball; 2],
    ) -> Errors {
        let (amplitude, relative) = absolute_and_relative_error(own, truth);
        Errors {
            deviation: self.deviation(own_motion),
            frequency: SizeBounds::default(),
            relative,
            drift: SizeBounds::default(),
            amplitude: Some(amplitude),
        }
    }

    /// Errors of a formula with this frequency and this motion.
    pub(super) fn errors(&self, own_frequency: &Ball, own_motion: &FourierSeries) -> Errors {
        let (frequency_error, relative) =
            absolute_and_relative_error(own_frequency, self.frequency);
        let (flattest, steepest) = largest(&own_motion.derivative());
        Errors {
            deviation: self.deviation(own_motion),
            relative,
            amplitude: None,
            drift: SizeBounds {
                lower: (flattest * frequency_error.lower).next_down().max(0.0),
                upper: (steepest * Bound::exactly(frequency_error.upper)).value(),
            },
            frequency: frequency_error,
        }
    }
}

/// Absolute and relative error of a number, each between two bounds.
fn absolute_and_relative_error(own: &Ball, truth: &Ball) -> (SizeBounds, SizeBounds) {
    let off = WORKING.difference(own, truth);
    let error = SizeBounds {
        lower: WORKING.distance_from_zero(&off).max(0.0),
        upper: WORKING.magnitude(&off).value(),
    };
    let smallest = WORKING.distance_from_zero(truth);
    let relative = SizeBounds {
        lower: (error.lower / WORKING.magnitude(truth).value()).next_down().max(0.0),
        upper: match smallest > 0.0 {
            true => Bound::exactly(error.upper).over(smallest).value(),
            false => f64::INFINITY,
        },
    };
    (error, relative)
}

/// A lower bound of the root mean square of a series.
fn below_mean(series: &FourierSeries) -> f64 {
    /// Bound of the rounding error of so short a sum.
    const ROUNDING: f64 = 1e-12;
    let square = |ball: &Ball| WORKING.distance_from_zero(ball).max(0.0).powi(2);
    let waves = series.cosines.iter().skip(1).chain(series.sines.iter().skip(1));
    let mean = square(&series.cosine(0)) + 0.5 * waves.map(square).sum::<f64>();
    (mean.sqrt() * (1.0 - ROUNDING) - series.tail.value()).max(0.0)
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
    // Half a turn suffices for an even or odd function, and for one that half a turn turns over.
    let turns_over = parts.iter().all(|balls| balls.iter().step_by(2).all(Ball::is_zero));
    let all = match (empty == [false, false], turns_over) {
        (true, false) => 2 * points,
        (true, true) => points,
        (false, false) => points + 1,
        (false, true) => points / 2 + 1,
    };
    let factor = |ball: &Ball| BallFactor::new(BALLS, ball);
    let short = parts.map(|balls| {
        let occurring = balls.iter().enumerate().filter(|(_, ball)| !ball.is_zero());
        let short = occurring.map(|(k, ball)| (k, factor(&BALLS.converted(ball, WORKING))));
        short.collect::<Vec<(usize, BallFactor)>>()
    });
    let table: Vec<[BallFactor; 2]> =
        table.iter().map(|waves| waves.each_ref().map(factor)).collect();
    let coefficients = short.iter().flatten().map(|(_, coefficient)| coefficient);
    let mut values = BallProductSums::new(all, coefficients.chain(table.iter().flatten()));
    for j in 0..all {
        for (wave, coefficients) in short.iter().enumerate() {
            for (k, coefficient) in coefficients {
                values.add(coefficient, &table[j * k % (2 * points)][wave], [(j, false)]);
            }
        }
    }
    let (mut lower, mut upper) = (0.0_f64, Bound::ZERO);
    for value in values.rounded(BALLS, BALLS.bits, 0) {
        lower = lower.max(BALLS.distance_from_zero(&value));
        upper = upper.max(BALLS.magnitude(&value));
    }
    // cos y >= 1 - y^2/2.
    let half_step = Bound::of_nearest(PI) * Bound::exactly(degree as f64) / (2 * points as u32);
    let between = (half_step * half_step / 2).below_complement();
    ((lower - series.tail.value()).next_down().max(0.0), upper.over(between) + series.tail)
}

/// Cosine and sine of the angles `pi j/points`, `j` below twice their number.
pub(super) fn waves(points: usize, balls: Balls) -> Vec<[Ball; 2]> {
    let step = WORKING.divided(&WORKING.pi(), u32::try_from(points).unwrap_or(u32::MAX));
    let unknown = || {
        let all = FourierSeries::exactly(vec![], vec![]).widened(Bound::exactly(1.0));
        (all.clone(), all)
    };
    let (sine, cosine) = FourierSeries::constant(step).sine_and_cosine().unwrap_or_else(unknown);
    let turn = [cosine.at_zero(), sine.at_zero()];
    let mut at = [WORKING.integer(1), Ball::zero()];
    // A quarter turn: the others are its mirror images.
    let mut quarter = Vec::with_capacity(points / 2 + 1);
    for _ in 0..=points / 2 {
        quarter.push(at.each_ref().map(|value| balls.converted(value, WORKING)));
        at = sum_of_angles(&at, &turn);
    }
    let signed = |ball: &Ball, negative: bool| match negative {
        true => balls.difference(&Ball::zero(), ball),
        false => ball.clone(),
    };
    let place = |j: usize| {
        let in_half = j.min(2 * points - j);
        let [cosine, sine] = &quarter[in_half.min(points - in_half)];
        [signed(cosine, 2 * in_half > points), signed(sine, j > points)]
    };
    (0..2 * points).map(place).collect()
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
    hold_upper("the radius", certified.proof.radius.value(), radius)?;
    if let (Some(claimed), Some(errors)) = (formula, &certified.formula) {
        let amplitude = errors.amplitude.unwrap_or_default();
        let both = [
            ("the error of the amplitude", amplitude, &claimed.amplitude_error),
            ("the deviation", errors.deviation, &claimed.deviation),
            ("the error of the frequency", errors.frequency, &claimed.frequency_error),
            ("the drift", errors.drift, &claimed.drift),
        ];
        for (what, proved, claim) in both {
            hold_both(what, proved, claim)?;
        }
    }
    Ok(())
}

/// Holds a claimed upper bound against the proved one.
fn hold_upper(what: &'static str, proved: f64, claim: &Rational) -> Result<(), CheckError> {
    match from_f64(proved).is_some_and(|proved| proved <= *claim) {
        true => Ok(()),
        false => Err(CheckError::ClaimedLess { what, proved }),
    }
}

/// Holds a claimed lower and a claimed upper bound against the proved ones.
///
/// # Errors
/// A claim that is not proved.
pub(super) fn hold_both(
    what: &'static str,
    proved: SizeBounds,
    claim: &[Rational; 2],
) -> Result<(), CheckError> {
    match from_f64(proved.lower).is_some_and(|proved| claim[0] <= proved) {
        true => hold_upper(what, proved.upper, &claim[1]),
        false => Err(CheckError::ClaimedMore { what, proved: proved.lower }),
    }
}

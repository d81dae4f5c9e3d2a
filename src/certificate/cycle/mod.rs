//! Certificates of limit cycles: `x'' + g(x) x' + h(x) = 0`, whose motion has an amplitude and a phase of its own.
//!
//! In: numbers from which a cycle can be proved, anything. Out: that there is exactly one so near, its frequency, whether it attracts, and
//! how far a formula for it is off. Where a motion on a cycle begins is free: here, and in the formula that is compared, the first
//! harmonic has no sine.

mod candidate;
mod theorem;

use num_traits::{Signed as _, Zero as _};

pub use candidate::certify_cycle;

use super::force::{along, is_even, is_odd};
use super::formula::{self, Enclosure, JudgedFormula, Truth};
use super::fourier_series::{FourierSeries, WORKING, Wave};
use super::radii_polynomial::{NotProved, Proof};
use super::{Certified, CheckError, HIGHEST_HARMONIC, Sizes};
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::{Integer, Rational};
use crate::expr::{Expr, ExprError};

/// Numbers from which a limit cycle can be proved. They may be anything: [`check_cycle`] trusts none of them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CycleCertificate {
    /// `g` of `x'' + g(x) x' + h(x) = 0`, in the letter [`x`](super::coordinate) and numbers.
    pub damping: Expr,
    /// `h`, likewise.
    pub force: Expr,
    /// Whether the motion has odd harmonics alone, as it may where `g` is even and `h` odd.
    pub odd: bool,
    /// `reciprocal` and the coefficients are integers times `2^-bits`.
    pub bits: usize,
    /// About `1/omega`.
    pub reciprocal: Integer,
    /// About the cosine coefficients of the motion, that of the constant first.
    pub cosines: Vec<Integer>,
    /// About the sine coefficients by harmonic; that of the constant and that of the first harmonic are zero.
    pub sines: Vec<Integer>,
    /// The last harmonic of the block, odd where `odd`.
    pub highest: usize,
    /// The entries of the inverse are integers times `2^-inverse_bits`.
    pub inverse_bits: usize,
    /// About the inverse of the derivative on the block, row by row. The columns are those of the equations: the sine of the first harmonic,
    /// then of each harmonic the cosine and the sine, as far as they are left. The rows are those of the unknowns: `1/omega`, then
    /// the same.
    pub inverse: Vec<Vec<Integer>>,
    /// The weight of `1/omega` in the norm is `2^sigma`.
    pub sigma: i32,
    /// The radius that is claimed.
    pub claim: Rational,
    /// The formula that is judged, and what is claimed of it.
    pub formula: Option<JudgedFormula>,
}

/// Checks every inequality of the theorem for cycles, and every claim.
///
/// # Errors
/// [`CheckError`].
///
/// ```
/// use lindstedt::certificate::{certify_cycle, check_cycle};
/// use lindstedt::{Options, Oscillator, solve};
///
/// let oscillator = Oscillator::parse("x'' - mu*(1 - x^2)*x' + x = 0")?;
/// let solution = solve(&oscillator, &Options { order: Some(2), ..Options::default() })?;
/// let (certificate, certified) = certify_cycle(&oscillator, &solution, &"mu = 1/2".parse()?)?;
/// let errors = certified.formula.as_ref().ok_or("no formula")?;
/// assert!(errors.frequency.lower > 4.6e-4 && errors.frequency.upper < 4.8e-4);
/// assert!(certified.exponent.as_ref().is_some_and(|exponent| exponent.middle < lindstedt::exact::ratio(-1, 2)));
/// assert_eq!(check_cycle(&certificate)?, certified);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_cycle(certificate: &CycleCertificate) -> Result<Certified, CheckError> {
    certificate.well_formed().map_err(CheckError::Malformed)?;
    let proof = theorem::prove(certificate).map_err(CheckError::NotProved)?;
    let certified = certificate.certified(proof).map_err(CheckError::NotProved)?;
    formula::hold_claims(&certificate.claim, certificate.formula.as_ref(), &certified)?;
    Ok(certified)
}

impl CycleCertificate {
    /// The step from one harmonic to the next.
    fn step(&self) -> usize {
        if self.odd { 2 } else { 1 }
    }

    /// The equations of the block, that of the sine of the first harmonic first; of the unknowns `1/omega` has its place.
    fn block(&self) -> Vec<Wave> {
        let harmonics = (usize::from(self.odd)..=self.highest).step_by(self.step());
        let waves = harmonics.flat_map(|k| [Wave::Cosine(k), Wave::Sine(k)]);
        let others = waves.filter(|wave| !matches!(wave, Wave::Sine(0 | 1)));
        [Wave::Sine(1)].into_iter().chain(others).collect()
    }

    fn reciprocal_ball(&self) -> Ball {
        WORKING.dyadic(&self.reciprocal, self.bits)
    }

    /// The approximate motion.
    fn motion(&self) -> FourierSeries {
        let balls = |units: &[Integer]| units.iter().map(|units| WORKING.dyadic(units, self.bits)).collect();
        FourierSeries::exactly(balls(&self.cosines), balls(&self.sines)).of_digits(self.bits)
    }

    /// Not above `1/omega`.
    fn size_of_reciprocal(&self) -> f64 {
        match self.reciprocal.is_positive() {
            true => WORKING.distance_from_zero(&self.reciprocal_ball()),
            false => 0.0,
        }
    }

    /// Not above the size of the cosine of the first harmonic.
    fn size_of_first_harmonic(&self) -> f64 {
        WORKING.distance_from_zero(&self.motion().cosine(1))
    }

    /// Whether the equation is odd and the motion has odd harmonics alone.
    fn is_odd(&self) -> Result<bool, ExprError> {
        let mut even = self.cosines.iter().step_by(2).chain(self.sines.iter().step_by(2));
        Ok(is_even(&self.damping)? && is_odd(&self.force)? && even.all(|c| c.is_zero()))
    }

    /// What does not fit together.
    fn well_formed(&self) -> Result<(), &'static str> {
        let fits = Sizes {
            bits: [self.bits, self.inverse_bits],
            sigma: self.sigma,
            highest: self.highest,
            odd: self.odd,
            number: &self.reciprocal,
            coefficients: &[&self.cosines, &self.sines],
            inverse: &self.inverse,
            expressions: &[&self.damping, &self.force],
        };
        // Sizes before arithmetic: the block may be as long as it is said to be.
        fits.of_numbers()?;
        let unknowns = self.block().len();
        if unknowns > HIGHEST_HARMONIC + 1 {
            return Err("a block of more than 401 unknowns");
        }
        fits.of_inverse(unknowns)?;
        match self.sines.iter().take(2).all(|sine| sine.is_zero()) {
            true => Ok(()),
            false => Err("a sine of the first harmonic, or one of the constant"),
        }
    }

    /// What follows from a proof.
    ///
    /// # Errors
    /// A frequency without a value, or a damping without one.
    fn certified(&self, proof: Proof) -> Result<Certified, NotProved> {
        let mut reciprocal = self.reciprocal_ball();
        reciprocal.radius += proof.radius.over(Bound::power_of_two(self.sigma).value());
        let frequency = WORKING.quotient(&WORKING.integer(1), &reciprocal);
        let frequency = frequency.ok_or(NotProved::TooLarge(proof.radius))?;
        let motion = self.motion();
        // By Liouville's formula the product of the multipliers is exp of minus the integral of g, and one of them is one.
        let damping = along(&self.damping, &motion.clone().widened(proof.radius))?;
        let mut exponent = WORKING.scaled(&damping.cosine(0), -1);
        exponent.radius += damping.tail;
        let truth = Truth {
            motion: &motion,
            frequency: &frequency,
            radius: proof.radius,
        };
        let formula = self
            .formula
            .as_ref()
            .map(|formula| truth.errors(&formula.frequency_ball(self.bits), &turned(formula.motion(self.bits))));
        Ok(Certified {
            proof,
            frequency: Enclosure::of(&frequency),
            exponent: Some(Enclosure::of(&exponent)),
            formula,
        })
    }
}

/// The same motion with another phase: that where the first harmonic is a positive cosine; as it is where it has no first harmonic.
fn turned(motion: FourierSeries) -> FourierSeries {
    let (cosine, sine) = (motion.cosine(1), motion.sine(1));
    if sine.is_zero() && cosine.middle.is_positive() {
        return motion;
    }
    let square = WORKING.sum(&WORKING.product(&cosine, &cosine), &WORKING.product(&sine, &sine));
    let part = |ball: &Ball| WORKING.quotient(ball, &WORKING.root(&square, 2)?);
    match part(&cosine).zip(part(&sine)) {
        Some((cosine, sine)) => motion.turned(&[cosine, sine]),
        None => motion,
    }
}

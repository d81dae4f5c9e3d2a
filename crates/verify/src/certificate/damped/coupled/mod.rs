//! Certificates of driven motions of several coordinates.
//!
//! In: any numbers from which a motion of `q'' + G(q) q' + h(q, cos(Omega t), sin(Omega t)) = 0` may
//! be proved, each row of G the derivative of a function of the positions. Out: a proof that there
//! is exactly one motion near them that repeats itself with the drive, and the amplitude of a
//! harmonic of each coordinate. The theorem is that of one coordinate.

mod candidate;

use num_traits::Zero as _;

use super::super::formula::{self, Enclosure};
use super::super::fourier_series::{FourierSeries, WORKING};
use super::super::radii_polynomial::{NotProved, Proof};
use super::super::{Certified, CheckError, HIGHEST_HARMONIC, Sizes};
use super::theorem::{self, DampedProblem, waves_of_drive};
use super::{Drive, amplitude_of};
use crate::exact::{Integer, Rational};
use crate::expr::Expr;
use crate::symbol::Symbol;
pub use candidate::certify_coupled;

/// Numbers from which a steady motion of several driven coordinates can be proved. They may be
/// anything: [`check_coupled`] trusts none of them.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledCertificate {
    /// The symbols of the coordinates, none of them `c` or `s`.
    pub coordinates: Vec<Symbol>,
    /// `G` of `q'' + G(q) q' + h = 0`, a row for each equation, in the coordinates and numbers.
    pub damping: Vec<Vec<Expr>>,
    /// `h`, one for each coordinate, in the coordinates and numbers and in `c` and `s`, which stand
    /// for `cos(Omega t)` and `sin(Omega t)`.
    pub forces: Vec<Expr>,
    /// The drive.
    pub drive: Drive,
    /// Whether the motion has odd harmonics alone, as it may where half a period later the equations
    /// are their mirror image.
    pub odd: bool,
    /// The coefficients are integers times `2^-bits`.
    pub bits: usize,
    /// Approximate cosine coefficients of each coordinate, that of the constant first.
    pub cosines: Vec<Vec<Integer>>,
    /// Approximate sine coefficients of each coordinate by harmonic; that of the constant is zero.
    pub sines: Vec<Vec<Integer>>,
    /// The last harmonic of the block, odd where `odd`.
    pub highest: usize,
    /// The entries of the inverse are integers times `2^-inverse_bits`.
    pub inverse_bits: usize,
    /// Approximate inverse of the derivative on the block, row by row: the cosine and the sine of
    /// each harmonic, coordinate by coordinate.
    pub inverse: Vec<Vec<Integer>>,
    /// The radius that is claimed.
    pub claim: Rational,
}

/// The largest number of coordinates.
const MOST_COORDINATES: usize = 40;

/// The largest number of unknowns of a block.
const MOST_UNKNOWNS: usize = HIGHEST_HARMONIC + 1;

/// Checks every inequality of the theorem for driven motions of several coordinates, and every
/// claim.
///
/// # Errors
/// [`CheckError`].
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::{certify_coupled, check_coupled};
/// use lindstedt::coupled::CoupledEquations;
///
/// let pair = "x'' + x'/10 + 2*x - y + x^3/2 = cos(Omega*t)/4; y'' + y'/10 + 2*y - x = 0";
/// let equations = CoupledEquations::parse(pair)?;
/// let (mut certificate, certified) = certify_coupled(&equations, &"Omega = 11/10".parse()?)?;
/// assert!(certified.amplitudes[1].radius.value() < 1e-30);
/// assert_eq!(check_coupled(&certificate)?, certified);
/// certificate.cosines[1][1] += lindstedt::exact::Integer::from(1) << 40;
/// assert!(check_coupled(&certificate).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_coupled(certificate: &CoupledCertificate) -> Result<Certified, CheckError> {
    certificate.well_formed().map_err(CheckError::Malformed)?;
    let proof = theorem::prove(certificate.problem()).map_err(CheckError::NotProved)?;
    let certified = certificate.certified(proof).map_err(CheckError::NotProved)?;
    formula::hold_claims(&certificate.claim, None, &certified)?;
    Ok(certified)
}

impl CoupledCertificate {
    /// Returns the equations and the approximate motion of this certificate in the form that the
    /// theorem takes.
    pub(super) fn problem(&self) -> DampedProblem<'_> {
        let periods = Rational::from_integer(Integer::from(self.drive.periods));
        DampedProblem {
            damping: self.damping.iter().map(|row| row.iter().collect()).collect(),
            forces: self.forces.iter().collect(),
            coordinates: self.coordinates.clone(),
            drive: Some(self.drive.periods),
            odd: self.odd,
            motions: self.motions(),
            reciprocal: WORKING.fraction(&(periods / &self.drive.frequency)),
            highest: self.highest,
            inverse: &self.inverse,
            inverse_bits: self.inverse_bits,
            sigma: 0,
        }
    }

    /// h with the sines and cosines of time `t`.
    pub fn forces_in_time(&self) -> Vec<Expr> {
        self.forces.iter().map(|force| self.drive.in_time(force)).collect()
    }

    /// The approximate motion of each coordinate.
    fn motions(&self) -> Vec<FourierSeries> {
        let balls = |units: &[Integer]| {
            units.iter().map(|units| WORKING.dyadic(units, self.bits)).collect()
        };
        let motion = |(cosines, sines): (&Vec<Integer>, &Vec<Integer>)| {
            FourierSeries::exactly(balls(cosines), balls(sines)).of_digits(self.bits)
        };
        self.cosines.iter().zip(&self.sines).map(motion).collect()
    }

    /// Returns the frequency and the amplitudes that follow from a proof.
    ///
    /// # Errors
    /// A frequency without a value.
    fn certified(&self, proof: Proof) -> Result<Certified, NotProved> {
        let one = WORKING.integer(1);
        let frequency = WORKING.quotient(&one, &self.problem().reciprocal);
        let frequency = frequency.ok_or(NotProved::TooLarge(proof.radius))?;
        let amplitude = |motion: &FourierSeries| {
            let mut amplitude = amplitude_of(motion, self.drive.harmonic);
            amplitude.radius += proof.radius;
            Enclosure::from_ball(&amplitude)
        };
        Ok(Certified {
            proof,
            frequency: Enclosure::from_ball(&frequency),
            exponent: None,
            multipliers: None,
            amplitude: None,
            amplitudes: self.motions().iter().map(amplitude).collect(),
            copies: 1,
            law_is_held: false,
            formula: None,
        })
    }

    /// Checks that sizes, letters and numbers fit together; the error names what does not.
    fn well_formed(&self) -> Result<(), &'static str> {
        let count = self.coordinates.len();
        let apart = |(place, name)| !self.coordinates[..place].contains(name);
        let demands = [
            ((1..=MOST_COORDINATES).contains(&count), "more than 40 coordinates, or none"),
            (self.coordinates.iter().enumerate().all(apart), "two coordinates of one name"),
            (
                waves_of_drive().iter().all(|wave| !self.coordinates.contains(wave)),
                "a coordinate with the name of a wave of the drive",
            ),
            (
                self.forces.len() == count
                    && self.damping.len() == count
                    && self.damping.iter().all(|row| row.len() == count)
                    && self.cosines.len() == count
                    && self.sines.len() == count,
                "another number of forces, dampings or motions than of coordinates",
            ),
        ];
        if let Some((_, reason)) = demands.into_iter().find(|(holds, _)| !holds) {
            return Err(reason);
        }
        let lists: Vec<&[Integer]> =
            self.cosines.iter().chain(&self.sines).map(Vec::as_slice).collect();
        let letters: Vec<Symbol> =
            self.coordinates.iter().copied().chain(waves_of_drive()).collect();
        let damping = self.damping.iter().flatten().map(|entry| (entry, &letters[..count]));
        let forces = self.forces.iter().map(|force| (force, letters.as_slice()));
        let fits = Sizes {
            bits: [self.bits, self.inverse_bits],
            sigma: 0,
            highest: self.highest,
            odd: self.odd,
            number: &Integer::zero(),
            coefficients: &lists,
            inverse: &self.inverse,
            expressions: &damping.chain(forces).collect::<Vec<_>>(),
        };
        fits.of_numbers()?;
        self.drive.well_formed()?;
        let problem = self.problem();
        let unknowns = problem.block().len();
        if unknowns > MOST_UNKNOWNS {
            return Err("a block of more than 401 unknowns");
        }
        fits.of_inverse(unknowns)?;
        if !self.sines.iter().all(|sines| sines.first().is_none_or(Integer::is_zero)) {
            return Err("a sine of the constant");
        }
        match problem.has_potential_damping() {
            Ok(true) => Ok(()),
            _ => Err("a row of the damping that is no derivative of a function of the positions"),
        }
    }

    /// Whether half a period later the equations are their mirror image.
    fn is_odd(&self) -> Result<bool, crate::expr::ExprError> {
        let mut problem = self.problem();
        problem.motions = vec![];
        problem.is_odd()
    }
}

/// The last harmonic of the largest block of so many coordinates; with odd ones alone it is odd.
const fn last_harmonic_of_largest_block(coordinates: usize, odd: bool) -> usize {
    let pairs = (MOST_UNKNOWNS / coordinates - 1) / 2;
    let last = if odd { 2 * pairs - 1 } else { pairs };
    if last < HIGHEST_HARMONIC { last } else { HIGHEST_HARMONIC - 1 }
}

#[cfg(test)]
pub(super) mod tests;

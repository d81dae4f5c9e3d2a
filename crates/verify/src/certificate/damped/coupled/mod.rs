//! Certificates of limit cycles and of driven motions of several coordinates.
//!
//! In: any numbers from which a motion of `q'' + G(q) q' + h(q, cos(Omega t), sin(Omega t)) = 0` may
//! be proved, each row of G the derivative of a function of the positions; without a drive h is one
//! of the positions alone. Out: a proof that there is exactly one motion near them that repeats
//! itself with the drive, or with a period of its own, the amplitude of a harmonic of each
//! coordinate, and the stability. The theorem is that of one coordinate.

mod candidate;

use num_traits::{Signed as _, Zero as _};

use super::super::formula::{self, Enclosure};
use super::super::fourier_series::{FourierSeries, WORKING};
use super::super::radii_polynomial::{NotProved, Proof};
use super::super::{Certified, CheckError, HIGHEST_HARMONIC, Sizes};
use super::problem::{DampedProblem, waves_of_drive};
use super::theorem;
use super::{ClaimedStability, Drive, amplitude_of, frequency, reciprocal, stability};
use crate::exact::{Integer, Rational};
use crate::expr::Expr;
use crate::symbol::Symbol;
pub use candidate::certify_coupled;

/// Numbers from which a steady motion of several driven coordinates can be proved, or a limit cycle
/// of several coordinates without a drive. They may be anything: [`check_coupled`] trusts none of
/// them.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledCertificate {
    /// The symbols of the coordinates, with a drive none of them `c` or `s`.
    pub coordinates: Vec<Symbol>,
    /// `G` of `q'' + G(q) q' + h = 0`, a row for each equation, in the coordinates and numbers.
    pub damping: Vec<Vec<Expr>>,
    /// `h`, one for each coordinate, in the coordinates and numbers; with a drive also in `c` and
    /// `s`, which stand for `cos(Omega t)` and `sin(Omega t)`.
    pub forces: Vec<Expr>,
    /// The drive; `None` for a limit cycle.
    pub drive: Option<Drive>,
    /// The place of the coordinate whose first harmonic is a positive cosine in a limit cycle; zero
    /// with a drive.
    pub phase: usize,
    /// Whether the motion has odd harmonics alone, as it may where half a period later the equations
    /// are their mirror image.
    pub odd: bool,
    /// `reciprocal` and the coefficients are integers times `2^-bits`.
    pub bits: usize,
    /// Approximate `1/omega`; zero if the drive gives it.
    pub reciprocal: Integer,
    /// Approximate cosine coefficients of each coordinate, that of the constant first.
    pub cosines: Vec<Vec<Integer>>,
    /// Approximate sine coefficients of each coordinate by harmonic; that of the constant is zero,
    /// and for a limit cycle that of the first harmonic of the coordinate `phase`, too.
    pub sines: Vec<Vec<Integer>>,
    /// The last harmonic of the block, odd where `odd`.
    pub highest: usize,
    /// The entries of the inverse are integers times `2^-inverse_bits`.
    pub inverse_bits: usize,
    /// Approximate inverse of the derivative on the block, row by row: the cosine and the sine of
    /// each harmonic, coordinate by coordinate. For a limit cycle the sine of the first harmonic of
    /// the coordinate `phase` comes first among the columns, and `1/omega` takes its place among the
    /// rows.
    pub inverse: Vec<Vec<Integer>>,
    /// The weight of `1/omega` in the norm is `2^sigma`; zero where the drive gives it.
    pub sigma: i32,
    /// The radius that is claimed.
    pub claim: Rational,
    /// The stability that is claimed; `None` if none is.
    pub stability: Option<ClaimedStability>,
}

/// The largest number of coordinates.
const MOST_COORDINATES: usize = 40;

/// The largest number of unknowns of a block.
const MOST_UNKNOWNS: usize = HIGHEST_HARMONIC + 1;

/// Checks every inequality of the theorem for limit cycles and driven motions of several
/// coordinates, and every claim.
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
    if let Some(claimed) = &certificate.stability {
        claimed.hold(certified.stability.as_ref())?;
    }
    Ok(certified)
}

impl CoupledCertificate {
    /// Returns the equations and the approximate motion of this certificate in the form that the
    /// theorem takes.
    pub(super) fn problem(&self) -> DampedProblem<'_> {
        DampedProblem {
            damping: self.damping.iter().map(|row| row.iter().collect()).collect(),
            forces: self.forces.iter().collect(),
            coordinates: self.coordinates.clone(),
            drive: self.drive.as_ref().map(|drive| drive.periods),
            phase: self.phase,
            odd: self.odd,
            motions: self.motions(),
            reciprocal: reciprocal(self.drive.as_ref(), &self.reciprocal, self.bits),
            highest: self.highest,
            inverse: &self.inverse,
            inverse_bits: self.inverse_bits,
            sigma: self.sigma,
        }
    }

    /// h with the sines and cosines of time `t`, where it has a drive.
    pub fn forces_in_time(&self) -> Vec<Expr> {
        match &self.drive {
            Some(drive) => self.forces.iter().map(|force| drive.in_time(force)).collect(),
            None => self.forces.clone(),
        }
    }

    /// The harmonic whose amplitudes are proved: the first of a limit cycle.
    pub fn harmonic(&self) -> usize {
        self.drive.as_ref().map_or(1, |drive| drive.harmonic)
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
        let frequency = frequency(&self.problem(), proof.radius)?;
        let amplitude = |motion: &FourierSeries| {
            let mut amplitude = amplitude_of(motion, self.harmonic());
            amplitude.radius += proof.radius;
            Enclosure::from_ball(&amplitude)
        };
        Ok(Certified {
            proof,
            frequency: Enclosure::from_ball(&frequency),
            exponent: None,
            multipliers: None,
            stability: Some(stability::stability(&self.problem(), proof.radius)),
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
                self.drive.is_none()
                    || waves_of_drive().iter().all(|wave| !self.coordinates.contains(wave)),
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
            (self.phase < count, "a phase of no coordinate"),
        ];
        if let Some((_, reason)) = demands.into_iter().find(|(holds, _)| !holds) {
            return Err(reason);
        }
        let lists: Vec<&[Integer]> =
            self.cosines.iter().chain(&self.sines).map(Vec::as_slice).collect();
        let waves = self.drive.iter().flat_map(|_| waves_of_drive());
        let letters: Vec<Symbol> = self.coordinates.iter().copied().chain(waves).collect();
        let damping = self.damping.iter().flatten().map(|entry| (entry, &letters[..count]));
        let forces = self.forces.iter().map(|force| (force, letters.as_slice()));
        let fits = Sizes {
            bits: [self.bits, self.inverse_bits],
            sigma: self.sigma,
            highest: self.highest,
            odd: self.odd,
            number: &self.reciprocal,
            coefficients: &lists,
            inverse: &self.inverse,
            expressions: &damping.chain(forces).collect::<Vec<_>>(),
        };
        fits.of_numbers()?;
        if let Some(drive) = &self.drive {
            drive.well_formed()?;
            if !(self.reciprocal.is_zero() && self.sigma == 0 && self.phase == 0) {
                return Err("a frequency or a phase beside that of the drive, or a weight of it");
            }
        }
        let problem = self.problem();
        let unknowns = problem.block().len();
        if unknowns > MOST_UNKNOWNS {
            return Err("a block of more than 401 unknowns");
        }
        fits.of_inverse(unknowns)?;
        if !self.sines.iter().all(|sines| sines.first().is_none_or(Integer::is_zero)) {
            return Err("a sine of the constant");
        }
        if self.drive.is_none() {
            let first = |lists: &[Vec<Integer>]| lists[self.phase].get(1).cloned();
            if !first(&self.cosines).is_some_and(|first| first.is_positive())
                || !first(&self.sines).is_none_or(|first| first.is_zero())
            {
                return Err("a first harmonic that is no positive cosine");
            }
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

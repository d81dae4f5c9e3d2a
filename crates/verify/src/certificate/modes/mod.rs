//! Certificates of nonlinear normal modes: free motions of several coordinates that begin at rest.
//!
//! In: any numbers from which a motion of `q'' + f(q) = 0` may be proved. Out: a proof that there is
//! exactly one motion near them with this amplitude, its frequency, and the error of a formula for
//! it. The amplitude is the start of one coordinate, or that of the first harmonic of a sum of all,
//! each with its factor: only the first couples the condition to all harmonics. The theorem is that
//! of one coordinate.

mod candidate;

use num_traits::{Signed as _, Zero as _};

use super::formula::{self, JudgedFormula};
use super::fourier_series::{FourierSeries, WORKING};
use super::theorem::{self, Condition, ConservativeProblem};
use super::{Certified, CheckError, HIGHEST_HARMONIC, Sizes, law};
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::{Integer, Rational};
use crate::expr::Expr;
use crate::symbol::Symbol;
pub use candidate::{certify_mode, certify_mode_motion};

/// The definition of the amplitude of a mode.
#[derive(Clone, Debug, PartialEq)]
pub enum ModeAmplitude {
    /// The start of the coordinate of this index.
    Start(usize),
    /// The amplitude of the first harmonic of the sum of the coordinates, each with its factor, an
    /// expression without symbols.
    FirstHarmonic(Vec<Expr>),
}

/// Numbers from which a free motion of several coordinates can be proved. They may be anything:
/// [`check_mode`] trusts none of them.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeCertificate {
    /// The symbols of the coordinates.
    pub coordinates: Vec<Symbol>,
    /// `f` of `q'' + f(q) = 0`, one for each coordinate, in the coordinates and numbers.
    pub forces: Vec<Expr>,
    /// The definition of the amplitude.
    pub measure: ModeAmplitude,
    /// The amplitude; every velocity is zero at `t = 0`.
    pub amplitude: Rational,
    /// Whether the motion has odd harmonics alone, as it may where all forces are odd.
    pub odd: bool,
    /// `mu` and the coefficients are integers times `2^-bits`.
    pub bits: usize,
    /// Approximate `1/omega^2`.
    pub mu: Integer,
    /// Approximate cosine coefficients of each coordinate, that of the constant first.
    pub coefficients: Vec<Vec<Integer>>,
    /// The last harmonic of the block, odd where `odd`.
    pub highest: usize,
    /// The entries of the inverse are integers times `2^-inverse_bits`.
    pub inverse_bits: usize,
    /// Approximate inverse of the derivative on `mu` and the harmonics of the block, coordinate by
    /// coordinate; the first row belongs to `mu`, the first column to the condition on the
    /// amplitude.
    pub inverse: Vec<Vec<Integer>>,
    /// The weight of `mu` in the norm is `2^sigma`.
    pub sigma: i32,
    /// The radius that is claimed.
    pub claim: Rational,
    /// The formula that is judged, and what is claimed of it.
    pub formula: Option<JudgedFormula>,
}

/// The largest number of coordinates.
const MOST_COORDINATES: usize = 40;

/// The largest number of unknowns of a block.
const MOST_UNKNOWNS: usize = HIGHEST_HARMONIC + 1;

/// Checks every inequality of the theorem for a motion of several coordinates, and every claim.
///
/// # Errors
/// [`CheckError`].
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::{certify_mode, check_mode};
/// use lindstedt::modes::{FreeSystem, ModeOptions, derive};
///
/// let pair = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0")?;
/// let modes = derive(&pair, &ModeOptions { mode: Some(1), ..ModeOptions::default() })?;
/// let mode = modes.modes[0].as_ref().expect("no resonance");
/// let (mut certificate, certified) = certify_mode(&modes.system, mode, &"a = 4/5".parse()?)?;
/// let errors = certified.formula.as_ref().ok_or("no formula")?;
/// assert!(errors.relative.lower > 0.00126 && errors.relative.upper < 0.00127);
/// assert_eq!(check_mode(&certificate)?, certified);
/// certificate.amplitude = &certificate.amplitude + lindstedt::exact::ratio(1, 1_000_000_000);
/// assert!(check_mode(&certificate).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_mode(certificate: &ModeCertificate) -> Result<Certified, CheckError> {
    certificate.well_formed().map_err(CheckError::Malformed)?;
    let proof = theorem::prove(certificate.problem()).map_err(CheckError::NotProved)?;
    let certified = certificate.certified(proof).map_err(CheckError::NotProved)?;
    formula::hold_claims(&certificate.claim, certificate.formula.as_ref(), &certified)?;
    Ok(certified)
}

impl ModeCertificate {
    /// Returns the equations and the approximate motion of this certificate in the form that the
    /// theorem takes.
    fn problem(&self) -> ConservativeProblem<'_> {
        let amplitude = WORKING.fraction(&self.amplitude);
        let condition = match &self.measure {
            ModeAmplitude::Start(coordinate) => {
                Condition::Start { coordinate: *coordinate, place: amplitude }
            }
            ModeAmplitude::FirstHarmonic(factors) => {
                let unknown = || Ball { middle: Integer::zero(), radius: Bound::UNKNOWN };
                let factor = |factor: &Expr| law::exact_number(factor).unwrap_or_else(unknown);
                Condition::FirstHarmonic {
                    factors: factors.iter().map(factor).collect(),
                    amplitude,
                }
            }
        };
        ConservativeProblem {
            forces: self.forces.iter().collect(),
            coordinates: self.coordinates.clone(),
            condition,
            odd: self.odd,
            motions: self.motions(),
            mu: WORKING.dyadic(&self.mu, self.bits),
            highest: self.highest,
            inverse: &self.inverse,
            inverse_bits: self.inverse_bits,
            sigma: self.sigma,
        }
    }

    /// The approximate motion of each coordinate.
    fn motions(&self) -> Vec<FourierSeries> {
        let motion = |list: &Vec<Integer>| {
            let balls = list.iter().map(|units| WORKING.dyadic(units, self.bits));
            FourierSeries::exactly(balls.collect(), vec![]).of_digits(self.bits)
        };
        self.coefficients.iter().map(motion).collect()
    }

    /// Returns the frequency and the errors of the formula that follow from a proof.
    ///
    /// # Errors
    /// A frequency without a value.
    fn certified(&self, proof: super::Proof) -> Result<Certified, super::NotProved> {
        let mu = WORKING.dyadic(&self.mu, self.bits);
        let formula = self.formula.as_ref();
        formula::certified((mu, self.sigma), &self.motions(), self.bits, formula, proof)
    }

    /// Checks that sizes and numbers fit together; the error names what does not.
    fn well_formed(&self) -> Result<(), &'static str> {
        let count = self.coordinates.len();
        let apart = |(place, name)| !self.coordinates[..place].contains(name);
        let measure_fits = match &self.measure {
            ModeAmplitude::Start(coordinate) => *coordinate < count,
            ModeAmplitude::FirstHarmonic(factors) => factors.len() == count,
        };
        let demands = [
            ((1..=MOST_COORDINATES).contains(&count), "more than 40 coordinates, or none"),
            (self.coordinates.iter().enumerate().all(apart), "two coordinates of one name"),
            (
                self.forces.len() == count && self.coefficients.len() == count && measure_fits,
                "another number of forces, motions or factors than of coordinates",
            ),
        ];
        if let Some((_, reason)) = demands.into_iter().find(|(holds, _)| !holds) {
            return Err(reason);
        }
        let lists: Vec<&[Integer]> = self.coefficients.iter().map(Vec::as_slice).collect();
        let forces = self.forces.iter().map(|force| (force, self.coordinates.as_slice()));
        let factors = match &self.measure {
            ModeAmplitude::Start(_) => &[],
            ModeAmplitude::FirstHarmonic(factors) => factors.as_slice(),
        };
        let nothing: &[Symbol] = &[];
        let expressions: Vec<(&Expr, &[Symbol])> =
            forces.chain(factors.iter().map(|factor| (factor, nothing))).collect();
        let fits = Sizes {
            bits: [self.bits, self.inverse_bits],
            sigma: self.sigma,
            highest: self.highest,
            odd: self.odd,
            number: &self.mu,
            coefficients: &lists,
            inverse: &self.inverse,
            expressions: &expressions,
        };
        fits.of_numbers()?;
        if factors.iter().any(|factor| law::exact_number(factor).is_none()) {
            return Err("a factor of the amplitude without a value");
        }
        let unknowns = self.problem().block().len() + 1;
        if unknowns > MOST_UNKNOWNS {
            return Err("a block of more than 401 unknowns");
        }
        fits.of_inverse(unknowns)?;
        self.well_formed_formula()
    }

    /// Checks the formula, and that it belongs to the motion with which it is compared.
    ///
    /// # Errors
    /// The demand that does not hold.
    fn well_formed_formula(&self) -> Result<(), &'static str> {
        let Some(formula) = &self.formula else {
            return Ok(());
        };
        formula.well_formed(false)?;
        if formula.sines.iter().any(|sine| !sine.is_zero()) {
            return Err("a formula with sines, of a motion that begins at rest");
        }
        if formula.others.len() + 1 != self.coordinates.len() {
            return Err("a formula of another number of coordinates");
        }
        // Half a period later the motion begins at its other turning point: the formula must begin
        // on the same side.
        let measured = self.problem().condition_along(&formula.motions(self.bits));
        let same_side = WORKING.distance_from_zero(&measured) > 0.0
            && measured.middle.is_negative() == self.amplitude.is_negative();
        if !same_side {
            return Err("a formula that begins elsewhere than the motion");
        }
        let letter = formula.letters.amplitude;
        let amplitude = formula.values.iter().find(|(name, _)| *name == letter);
        if amplitude.is_some_and(|(_, value)| value.as_number() != Some(&self.amplitude)) {
            return Err("a law whose amplitude is not that of the motion");
        }
        law::law_matches_frequency(formula, self.bits).map(|_| ())
    }
}

/// The last harmonic of the largest block of so many coordinates.
const fn last_harmonic_of_largest_block(coordinates: usize, odd: bool) -> usize {
    let each = (MOST_UNKNOWNS - 1) / coordinates;
    let last = if odd { 2 * each - 1 } else { each - 1 };
    if last < HIGHEST_HARMONIC { last } else { HIGHEST_HARMONIC - 1 }
}

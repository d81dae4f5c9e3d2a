//! Certificates of equations with damping: limit cycles of `x'' + g(x) x' + h(x) = 0`, and steady
//! motions of such an equation with a drive in h.
//!
//! In: any numbers from which a motion may be proved. Out: a proof that there is exactly one motion
//! near them, its frequency or amplitude, whether a cycle attracts, and the error of a formula for
//! it. The phase of a motion on a cycle is free: here, and in the formula that is compared, the
//! first harmonic has no sine. The phase of a driven motion is determined by the drive. Driven
//! motions of several coordinates are in `coupled/`, and the theorem is of any number.

mod candidate;
mod coupled;
mod problem;
mod stability;
mod theorem;
mod waves;

use num_traits::{Signed as _, Zero as _};

use super::force::along;
use super::formula::{self, Enclosure, JudgedFormula, Truth};
use super::fourier_series::{FourierSeries, WORKING};
use super::radii_polynomial::{NotProved, Proof};
use super::{Certified, CheckError, HIGHEST_HARMONIC, Sizes, coordinate, law};
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::{Integer, Rational};
use crate::expr::{Expr, ExprError};
use crate::symbol::Symbol;
pub use candidate::{certify_cycle, certify_cycle_motion, certify_driven};
pub use coupled::{CoupledCertificate, certify_coupled, check_coupled};
use problem::{DampedProblem, waves_of_drive};
pub use stability::{ClaimedStability, Multipliers, Stability};

/// The drive of a motion, whose period is a whole number of drive periods.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drive {
    /// Omega, a positive fraction.
    pub frequency: Rational,
    /// Number n of drive periods in one period of the motion.
    pub periods: usize,
    /// The harmonic of the motion whose amplitude the formula is about.
    pub harmonic: usize,
}

/// Numbers from which a limit cycle can be proved, or a steady motion of a drive. They may be
/// anything: [`check_damped`] trusts none of them.
#[derive(Clone, Debug, PartialEq)]
pub struct DampedCertificate {
    /// `g` of `x'' + g(x) x' + h(x) = 0`, in the symbol [`x`](super::coordinate) and numbers.
    pub damping: Expr,
    /// `h` of the equation, in the same symbols; with a drive also in `c` and `s`, which stand for
    /// `cos(Omega t)` and `sin(Omega t)`.
    pub force: Expr,
    /// The drive; `None` for a limit cycle.
    pub drive: Option<Drive>,
    /// Whether the motion has odd harmonics alone, as it may where half a period later the equation
    /// is its mirror image: `g` is even and `h` odd.
    pub odd: bool,
    /// `reciprocal` and the coefficients are integers times `2^-bits`.
    pub bits: usize,
    /// Approximate `1/omega`; zero if the drive gives it.
    pub reciprocal: Integer,
    /// Approximate cosine coefficients of the motion, the constant first.
    pub cosines: Vec<Integer>,
    /// Approximate sine coefficients by harmonic; that of the constant is zero, and for a limit
    /// cycle that of the first harmonic, too.
    pub sines: Vec<Integer>,
    /// The last harmonic of the block, odd where `odd`.
    pub highest: usize,
    /// The entries of the inverse are integers times `2^-inverse_bits`.
    pub inverse_bits: usize,
    /// Approximate inverse of the derivative on the block, row by row. The columns belong to the
    /// equations: the sine of the first harmonic, then the remaining cosines and sines of each
    /// harmonic. The rows belong to the unknowns: `1/omega`, then the same coefficients. With a
    /// drive both are the cosine and the sine of each harmonic.
    pub inverse: Vec<Vec<Integer>>,
    /// The weight of `1/omega` in the norm is `2^sigma`; zero where the drive gives it.
    pub sigma: i32,
    /// The radius that is claimed.
    pub claim: Rational,
    /// The stability that is claimed; `None` if none is.
    pub stability: Option<ClaimedStability>,
    /// The formula that is judged, and what is claimed of it.
    pub formula: Option<JudgedFormula>,
}

/// Checks every inequality of the theorem for equations with damping, and every claim.
///
/// # Errors
/// [`CheckError`].
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::{certify_cycle, check_damped};
/// use lindstedt::{Options, Oscillator, solve};
///
/// let oscillator = Oscillator::parse("x'' - mu*(1 - x^2)*x' + x = 0")?;
/// let solution = solve(&oscillator, &Options { order: Some(2), ..Options::default() })?;
/// let (certificate, certified) = certify_cycle(&oscillator, &solution, &"mu = 1/2".parse()?)?;
/// let errors = certified.formula.as_ref().ok_or("no formula")?;
/// assert!(errors.frequency.lower > 4.6e-4 && errors.frequency.upper < 4.8e-4);
/// assert!(certified.exponent.as_ref().is_some_and(|exponent| exponent.middle < lindstedt::exact::ratio(-1, 2)));
/// assert_eq!(check_damped(&certificate)?, certified);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_damped(certificate: &DampedCertificate) -> Result<Certified, CheckError> {
    certificate.well_formed().map_err(CheckError::Malformed)?;
    let proof = theorem::prove(certificate.problem()).map_err(CheckError::NotProved)?;
    let certified = certificate.certified(proof).map_err(CheckError::NotProved)?;
    formula::hold_claims(&certificate.claim, certificate.formula.as_ref(), &certified)?;
    if let Some(claimed) = &certificate.stability {
        claimed.hold(certified.stability.as_ref())?;
    }
    Ok(certified)
}

impl DampedCertificate {
    /// Returns the equation and the approximate motion of this certificate in the form that the
    /// theorem takes.
    fn problem(&self) -> DampedProblem<'_> {
        DampedProblem {
            damping: vec![vec![&self.damping]],
            forces: vec![&self.force],
            coordinates: vec![coordinate()],
            drive: self.drive.as_ref().map(|drive| drive.periods),
            phase: 0,
            odd: self.odd,
            motions: vec![self.motion()],
            reciprocal: reciprocal(self.drive.as_ref(), &self.reciprocal, self.bits),
            highest: self.highest,
            inverse: &self.inverse,
            inverse_bits: self.inverse_bits,
            sigma: self.sigma,
        }
    }

    /// h with the sines and cosines of time `t`, where it has a drive.
    pub fn force_in_time(&self) -> Expr {
        match &self.drive {
            Some(drive) => drive.in_time(&self.force),
            None => self.force.clone(),
        }
    }

    /// Whether half a period later the equation is its mirror image.
    fn is_odd(&self) -> Result<bool, ExprError> {
        let mut problem = self.problem();
        problem.motions = vec![FourierSeries::exactly(vec![], vec![])];
        problem.is_odd()
    }

    /// The approximate motion.
    fn motion(&self) -> FourierSeries {
        let balls = |units: &[Integer]| {
            units.iter().map(|units| WORKING.dyadic(units, self.bits)).collect()
        };
        FourierSeries::exactly(balls(&self.cosines), balls(&self.sines)).of_digits(self.bits)
    }

    /// Checks that sizes, letters and numbers fit together; the error names what does not.
    fn well_formed(&self) -> Result<(), &'static str> {
        let drive = self.drive.as_ref();
        let waves = drive.map(|_| waves_of_drive()).into_iter().flatten();
        let letters: Vec<Symbol> = waves.chain([coordinate()]).collect();
        let fits = Sizes {
            bits: [self.bits, self.inverse_bits],
            sigma: self.sigma,
            highest: self.highest,
            odd: self.odd,
            number: &self.reciprocal,
            coefficients: &[&self.cosines, &self.sines],
            inverse: &self.inverse,
            expressions: &[(&self.damping, &letters[letters.len() - 1..]), (&self.force, &letters)],
        };
        // Sizes are checked before any arithmetic, because a certificate may claim a block of any
        // size.
        fits.of_numbers()?;
        if let Some(drive) = drive {
            drive.well_formed()?;
        }
        let unknowns = self.problem().block().len();
        if unknowns > HIGHEST_HARMONIC + 1 {
            return Err("a block of more than 401 unknowns");
        }
        fits.of_inverse(unknowns)?;
        if drive.is_none() && !self.cosines.get(1).is_some_and(|first| first.is_positive()) {
            return Err(
                "a first harmonic that is no positive cosine: half a period later the motion is the same",
            );
        }
        self.well_formed_formula()?;
        let given = if self.drive.is_some() { 1 } else { 2 };
        match self.sines.iter().take(given).all(|sine| sine.is_zero()) {
            _ if self.drive.is_some() && !(self.reciprocal.is_zero() && self.sigma == 0) => {
                Err("a frequency beside that of the drive, or a weight of it")
            }
            true => Ok(()),
            false => Err("a sine of the first harmonic, or one of the constant"),
        }
    }

    /// Checks the numbers and the law of the formula.
    ///
    /// # Errors
    /// The demand that does not hold.
    fn well_formed_formula(&self) -> Result<(), &'static str> {
        let Some(formula) = &self.formula else {
            return Ok(());
        };
        formula.well_formed(self.drive.is_some())?;
        self.law_is_held(formula).map(|_| ())
    }

    /// Returns whether the law of the formula was read and gives its numbers; `false` if the law is
    /// only words.
    ///
    /// # Errors
    /// A law that gives others.
    fn law_is_held(&self, formula: &JudgedFormula) -> Result<bool, &'static str> {
        match &self.drive {
            None => law::law_matches_frequency(formula, self.bits),
            Some(drive) => {
                let exact = waves::displacement(&formula.law, &formula.values, drive);
                law::hold_displacement(exact.as_ref(), formula, self.bits)
            }
        }
    }

    /// Returns the images of a motion under the symmetries of the equation, itself first. With a
    /// drive of n periods these are the motion any number of drive periods later. If the equation
    /// does not change with the sign of x, `-X` is one as well; if that holds half a drive period
    /// later, `-X` half a drive period later; and for a limit cycle `-X` half its own period later,
    /// whose first harmonic is a positive cosine too.
    fn copies(&self, motion: &FourierSeries) -> Result<Vec<FourierSeries>, ExprError> {
        let periods = self.drive.as_ref().map_or(1, |drive| drive.periods);
        let [alone, with_drive] = self.mirrors()?;
        // The angles pi j/n.
        let angles = formula::waves(periods, WORKING);
        let later = |j: usize| match j {
            0 => motion.clone(),
            _ => motion.phase_shifted(&angles[j]),
        };
        let mut copies: Vec<FourierSeries> = (0..periods).map(|m| later(2 * m)).collect();
        if alone {
            copies.extend((0..periods).map(|m| later(2 * m).scaled(-1)));
        }
        if with_drive {
            copies.extend((0..periods).map(|m| later(2 * m + 1).scaled(-1)));
        }
        Ok(copies)
    }

    /// Returns whether the mirror image of the equation is the equation itself, and whether it is
    /// that half a period of the drive later, or of the cycle; not those symmetries that a motion
    /// of odd harmonics has by itself.
    fn mirrors(&self) -> Result<[bool; 2], ExprError> {
        let problem = self.problem();
        let [cosine, sine] = waves_of_drive();
        let turned = |letters: &[Symbol]| problem.is_mirror_image(letters);
        Ok(match &self.drive {
            None => [false, !self.odd && turned(&[coordinate()])?],
            Some(drive) => {
                let is_own = drive.periods % 2 == 1;
                [
                    (!self.odd || is_own) && turned(&[coordinate()])?,
                    (!self.odd || !is_own) && turned(&[coordinate(), cosine, sine])?,
                ]
            }
        })
    }

    /// Returns the frequency, the motion and the errors of the formula that follow from a proof.
    ///
    /// # Errors
    /// A frequency without a value, or a damping without one.
    fn certified(&self, proof: Proof) -> Result<Certified, NotProved> {
        let frequency = frequency(&self.problem(), proof.radius)?;
        let motion = self.motion();
        let formula = self.formula.as_ref();
        // Only the comparison with a formula needs the copies.
        let copies = match formula {
            Some(_) => self.copies(&motion)?,
            None => vec![],
        };
        let truth = Truth { copies: &copies, frequency: &frequency, radius: proof.radius };
        let (exponent, multipliers, amplitude, errors) = match &self.drive {
            None => {
                let errors = |formula: &JudgedFormula| {
                    truth.errors(
                        &formula.frequency_ball(self.bits),
                        &with_cosine_phase(formula.motion(self.bits)),
                    )
                };
                let exponent = self.exponent(&motion, proof.radius)?;
                (Some(exponent), None, None, formula.map(errors))
            }
            Some(drive) => {
                let mut amplitude = amplitude_of(&motion, drive.harmonic);
                amplitude.radius += proof.radius;
                let errors = |formula: &JudgedFormula| {
                    let own = formula.motion(self.bits);
                    truth.errors_of_driven(&own, [&amplitude_of(&own, drive.harmonic), &amplitude])
                };
                let errors = formula.map(errors);
                let multipliers = stability::multipliers(&self.problem(), proof.radius);
                (None, multipliers, Some(Enclosure::from_ball(&amplitude)), errors)
            }
        };
        let stability = match &exponent {
            Some(exponent) => {
                let reciprocal = self.problem().reciprocal_within(proof.radius);
                Stability::of_exponent(exponent, &reciprocal)
            }
            None => multipliers.as_ref().map_or(Stability::UNKNOWN, Multipliers::stability),
        };
        Ok(Certified {
            proof,
            frequency: Enclosure::from_ball(&frequency),
            exponent: exponent.as_ref().map(Enclosure::from_ball),
            multipliers,
            stability: Some(stability),
            amplitude,
            amplitudes: vec![],
            copies: copies.len().max(1),
            law_is_held: formula.is_some_and(|formula| self.law_is_held(formula) == Ok(true)),
            formula: errors,
        })
    }

    /// The characteristic exponent of a limit cycle: by Liouville's formula the product of the
    /// multipliers is exp of minus the integral of g, and one of them is one.
    fn exponent(&self, motion: &FourierSeries, radius: Bound) -> Result<Ball, NotProved> {
        let damping = along(&self.damping, &motion.clone().widened(radius))?;
        let mut exponent = WORKING.scaled(&damping.cosine(0), -1);
        exponent.radius += damping.tail;
        Ok(exponent)
    }
}

impl Drive {
    /// A force with the sines and cosines of time `t` in place of their symbols.
    fn in_time(&self, force: &Expr) -> Expr {
        let phase = &Expr::number(self.frequency.clone()) * &Expr::symbol("t");
        let waves = [phase.cos(), phase.sin()].into_iter().flatten();
        let values = waves_of_drive().into_iter().zip(waves).collect();
        // If the substitution has no value, the force is shown as it is checked.
        force.substitute_all(&values).unwrap_or_else(|_| force.clone())
    }

    fn well_formed(&self) -> Result<(), &'static str> {
        const MOST_PERIODS: usize = 20;
        let small = |integer: &Integer| integer.bits() <= 700;
        let demands = [
            (self.frequency.is_positive(), "a drive whose frequency is not positive"),
            (
                small(self.frequency.numer()) && small(self.frequency.denom()),
                "a number of more than 200 digits",
            ),
            (
                (1..=MOST_PERIODS).contains(&self.periods),
                "a motion of more than 20 periods of the drive, or of none",
            ),
            (
                (1..=HIGHEST_HARMONIC).contains(&self.harmonic),
                "an amplitude of a harmonic beyond 400",
            ),
        ];
        match demands.into_iter().find(|(holds, _)| !holds) {
            Some((_, reason)) => Err(reason),
            None => Ok(()),
        }
    }
}

/// `1/omega`, with a drive exactly.
fn reciprocal(drive: Option<&Drive>, approximate: &Integer, bits: usize) -> Ball {
    match drive {
        None => WORKING.dyadic(approximate, bits),
        Some(drive) => {
            let periods = Rational::from_integer(Integer::from(drive.periods));
            WORKING.fraction(&(periods / &drive.frequency))
        }
    }
}

/// omega of every motion within a radius of that of a problem, of which `1/omega` counts as its
/// weight says.
///
/// # Errors
/// A frequency without a value.
fn frequency(problem: &DampedProblem, radius: Bound) -> Result<Ball, NotProved> {
    let frequency = WORKING.quotient(&WORKING.integer(1), &problem.reciprocal_within(radius));
    frequency.ok_or(NotProved::TooLarge(radius))
}

/// `sqrt(a_k^2 + b_k^2)`.
fn amplitude_of(motion: &FourierSeries, harmonic: usize) -> Ball {
    let (cosine, sine) = (motion.cosine(harmonic), motion.sine(harmonic));
    let square = WORKING.sum(&WORKING.product(&cosine, &cosine), &WORKING.product(&sine, &sine));
    WORKING.root(&square, 2).unwrap_or_else(|| {
        let mut near_zero = Ball::zero();
        near_zero.radius += WORKING.magnitude(&cosine) + WORKING.magnitude(&sine);
        near_zero
    })
}

/// The motion with its phase shifted so that the first harmonic is a positive cosine; unchanged if
/// it has no first harmonic.
fn with_cosine_phase(motion: FourierSeries) -> FourierSeries {
    let (cosine, sine) = (motion.cosine(1), motion.sine(1));
    if sine.is_zero() && cosine.middle.is_positive() {
        return motion;
    }
    let square = WORKING.sum(&WORKING.product(&cosine, &cosine), &WORKING.product(&sine, &sine));
    let part = |ball: &Ball| WORKING.quotient(ball, &WORKING.root(&square, 2)?);
    match part(&cosine).zip(part(&sine)) {
        Some((cosine, sine)) => motion.phase_shifted(&[cosine, sine]),
        None => motion,
    }
}

//! Certificates: a proof of the error of a closed form.
//!
//! In: an oscillator whose energy is conserved, an answer of any method to it, and numbers. Out: a
//! [`Certificate`], from which anybody can prove in exact arithmetic that there is exactly one
//! motion `x(t) = X(omega t)` with this start near a refined one, and [`Certified`], the
//! consequences for the formula: lower and upper bounds of the errors of its frequency and its
//! motion, and of the rate at which the two motions drift apart.
//!
//! ```text
//! x'' + f(x) = 0,  x(0) = A,  x'(0) = 0:      |x(t) - x~(t)| <= E + max|X~'| |omega - omega~| |t|    for all t
//! ```
//!
//! Free motions of several coordinates have a [`ModeCertificate`], and the same theorem.
//!
//! Limit cycles of `x'' + g(x) x' + h(x) = 0`, which have an amplitude and a phase of their own,
//! and steady motions of such an equation with a drive have a [`DampedCertificate`] and a theorem
//! in `damped/`; limit cycles and driven motions of several coordinates have a
//! [`CoupledCertificate`], and the same theorem.
//!
//! Periodic impact orbits of a linear driven oscillator between rigid walls have an
//! [`OrbitCertificate`] and the theorem in `orbit/`.
//!
//! The way in which the refined motion was found does not matter (`candidate.rs`: Newton's
//! iteration): the proof rests on `theorem.rs` and on the arithmetic of `force.rs`,
//! `fourier_series.rs` and balls. A certificate that fails says nothing about the formula.

mod approximate_inverse;
mod candidate;
mod damped;
mod double_series;
mod elementary;
mod force;
mod formula;
mod fourier_series;
mod impact;
mod largest_value;
mod law;
mod law_on_range;
mod modes;
mod orbit;
mod radii_polynomial;
mod sheet;
mod theorem;
mod validity;

use num_traits::{Signed as _, Zero as _};

pub use candidate::{NotCertified, certify, certify_motion};
pub use damped::{
    ClaimedStability, CoupledCertificate, DampedCertificate, Drive, Multipliers, Stability,
    certify_coupled, certify_cycle, certify_cycle_motion, certify_driven, check_coupled,
    check_damped,
};
pub use formula::{Enclosure, Errors, JudgedFormula, LettersOfLaw, SizeBounds};
pub use impact::{
    ImpactEnclosure, LossEnclosure, NotEnclosed, PowerLaw, enclose_dashpot_impact, enclose_impact,
    enclose_lossy_impact,
};
pub use law_on_range::{
    HuntCrossleyForce, LawCertificate, LawError, LawNotProved, LawQuantity, ModeBranch,
    MotionsOfLaw, StartOfLaw, TrueFrequency, check_law, restitution,
};
pub use modes::{ModeAmplitude, ModeCertificate, certify_mode, certify_mode_motion, check_mode};
pub use orbit::{
    CertifiedOrbit, ClaimedImpact, ClaimedOrbit, EnclosedImpact, ExactHarmonic, ExactWall,
    OrbitCertificate, OrbitNotProved, WalledOscillator, certify_orbit, check_orbits,
};
pub use radii_polynomial::{NotProved, Proof};
pub use validity::{RangeEnd, Validity, validity};

use crate::decimal::{rounded_down, rounded_up};
use crate::exact::ball::{Ball, Balls};
use crate::exact::bound::Bound;
use crate::exact::{Integer, Rational};
use crate::expr::Expr;
use crate::symbol::Symbol;
use fourier_series::{FourierSeries, WORKING};
use theorem::{Condition, ConservativeProblem};

/// The symbol of the displacement in every certificate.
pub fn coordinate() -> Symbol {
    Symbol::new("x")
}

/// The last harmonic of a block is at most this.
pub const HIGHEST_HARMONIC: usize = 400;

/// The most binary digits behind the point that a certificate may have.
pub const MOST_BITS: usize = 224;

/// Numbers from which a motion can be proved. They may be anything: [`check`] trusts none of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// `f` of `x'' + f(x) = 0`, in the symbol [`x`](coordinate) and numbers.
    pub force: Expr,
    /// `x(0)`; `x'(0) = 0`.
    pub start: Rational,
    /// Whether the motion has odd harmonics alone, as those of an odd force have.
    pub odd: bool,
    /// `mu` and the coefficients are integers times `2^-bits`.
    pub bits: usize,
    /// Approximate `1/omega^2`.
    pub mu: Integer,
    /// Approximate cosine coefficients of the motion, `c_0` first.
    pub coefficients: Vec<Integer>,
    /// The last harmonic of the block, odd where `odd`.
    pub highest: usize,
    /// The entries of the inverse are integers times `2^-inverse_bits`.
    pub inverse_bits: usize,
    /// Approximate inverse of the derivative on `mu` and the harmonics of the block, row by row;
    /// the first row belongs to `mu`, the first column to the condition `x(0) = A`.
    pub inverse: Vec<Vec<Integer>>,
    /// The weight of `mu` in the norm is `2^sigma`.
    pub sigma: i32,
    /// The radius that is claimed.
    pub claim: Rational,
    /// The formula that is judged, and what is claimed of it.
    pub formula: Option<JudgedFormula>,
}

/// The proved motion and its errors.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Certified {
    /// The proof that the motion exists and is the only one within its radius.
    pub proof: Proof,
    /// `omega`.
    pub frequency: Enclosure,
    /// Characteristic exponent of a limit cycle: neighbouring motions approach it exponentially at
    /// this rate if it is negative, and leave it if it is positive; `None` for a motion whose
    /// energy is conserved.
    pub exponent: Option<Enclosure>,
    /// Floquet multipliers of a driven motion of one coordinate; `None` for others, and where its variational equation
    /// has no series.
    pub multipliers: Option<Multipliers>,
    /// Stability of a limit cycle or of a driven motion, of one coordinate or several; `None` for a
    /// motion whose energy is conserved, of which it is not proved.
    pub stability: Option<Stability>,
    /// Amplitude of the harmonic of a driven motion that the formula is about.
    pub amplitude: Option<Enclosure>,
    /// Amplitude of the same harmonic of each coordinate, of a driven motion of several, and of the
    /// first harmonic on a limit cycle of several; empty for others.
    pub amplitudes: Vec<Enclosure>,
    /// The number of images of the proved motion under the symmetries of the equation, itself
    /// included: with a drive the motion any number of drive periods later, and for a symmetric
    /// equation its mirror image. A formula describes all of them.
    pub copies: usize,
    /// Set if the law of the formula was read as text and gives the numbers that are judged: the
    /// frequency, of a driven motion all.
    pub law_is_held: bool,
    /// Errors of the formula; `None` if none is judged.
    pub formula: Option<Errors>,
}

/// The reason why a certificate is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CheckError {
    /// Numbers that do not fit together, or are too large.
    #[error("not a certificate: {0}")]
    Malformed(&'static str),
    /// An inequality of the theorem does not hold.
    #[error("not certified: {0}")]
    NotProved(NotProved),
    /// The motion is proved, but a claimed number is smaller than the proved upper bound.
    #[error("not as claimed: {what} is proved to be {} at most, and less is claimed", rounded_up(*proved, 6))]
    ClaimedLess {
        /// The name of the number.
        what: &'static str,
        /// The proved upper bound.
        proved: f64,
    },
    /// The motion is proved, but a claimed number is larger than the proved lower bound.
    #[error("not as claimed: {what} is proved to be {} at least, and more is claimed", rounded_down(*proved, 6))]
    ClaimedMore {
        /// The name of the number.
        what: &'static str,
        /// The proved lower bound.
        proved: f64,
    },
    /// A law is not proved on its range.
    #[error("not certified: {0}")]
    Law(LawNotProved),
    /// An impact orbit is not proved.
    #[error("not certified: orbit {orbit}: {reason}")]
    Orbit {
        /// The number of the orbit, from 1 on.
        orbit: usize,
        /// The reason.
        reason: OrbitNotProved,
    },
    /// The motion is proved, but its stability is another one than is claimed, or not proved.
    #[error("not as claimed: the stability that is claimed is not proved")]
    Stability,
}

/// Checks every inequality of the theorem, and every claim.
///
/// # Errors
/// [`CheckError`].
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::{certify, check};
/// use lindstedt::exact::Integer;
/// use lindstedt::{Options, Oscillator, solve};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options { order: Some(2), ..Options::default() })?;
/// let (mut certificate, certified) = certify(&pendulum, &solution, &"A = 3/2".parse()?)?;
/// let errors = certified.formula.as_ref().ok_or("no formula")?;
/// assert!(errors.relative.lower > 0.0148 && errors.relative.upper < 0.0149);
/// assert_eq!(check(&certificate)?, certified);
/// certificate.mu += Integer::from(1_000_000_000_000_i64);
/// assert!(check(&certificate).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check(certificate: &Certificate) -> Result<Certified, CheckError> {
    certificate.well_formed().map_err(CheckError::Malformed)?;
    let proof = theorem::prove(certificate.problem()).map_err(CheckError::NotProved)?;
    let certified = certificate.certified(proof).map_err(CheckError::NotProved)?;
    formula::hold_claims(&certificate.claim, certificate.formula.as_ref(), &certified)?;
    Ok(certified)
}

impl Certificate {
    /// Shortens the coefficients of the motion to this many binary digits.
    fn shorten(&mut self, bits: usize) {
        let short = |units: &Integer| Balls { bits }.dyadic(units, self.bits).middle;
        self.coefficients = self.coefficients.iter().map(short).collect();
        self.mu = short(&self.mu);
        self.bits = bits;
    }

    /// Returns the equation and the approximate motion of this certificate in the form that the
    /// theorem takes.
    fn problem(&self) -> ConservativeProblem<'_> {
        ConservativeProblem {
            forces: vec![&self.force],
            coordinates: vec![coordinate()],
            parameter: None,
            condition: Condition::Start { coordinate: 0, place: WORKING.fraction(&self.start) },
            odd: self.odd,
            motions: vec![self.motion()],
            mu: self.mu_ball(),
            highest: self.highest,
            inverse: &self.inverse,
            inverse_bits: self.inverse_bits,
            sigma: self.sigma,
        }
    }

    /// Returns the frequency and the errors of the formula that follow from a proof.
    ///
    /// # Errors
    /// A frequency without a value.
    fn certified(&self, proof: Proof) -> Result<Certified, NotProved> {
        let (number, motion) = ((self.mu_ball(), self.sigma), self.motion());
        formula::certified(number, &[motion], self.bits, self.formula.as_ref(), proof)
    }

    fn mu_ball(&self) -> Ball {
        WORKING.dyadic(&self.mu, self.bits)
    }

    /// The approximate motion.
    fn motion(&self) -> FourierSeries {
        let balls = self.coefficients.iter().map(|units| WORKING.dyadic(units, self.bits));
        FourierSeries::exactly(balls.collect(), vec![]).of_digits(self.bits)
    }

    /// Checks that sizes and numbers fit together; the error names what does not.
    fn well_formed(&self) -> Result<(), &'static str> {
        let fits = Sizes {
            bits: [self.bits, self.inverse_bits],
            sigma: self.sigma,
            highest: self.highest,
            odd: self.odd,
            number: &self.mu,
            coefficients: &[&self.coefficients],
            inverse: &self.inverse,
            expressions: &[(&self.force, &[coordinate()])],
        };
        fits.of_numbers()?;
        fits.of_inverse(self.problem().block().len() + 1)?;
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
        // Half a period later the motion begins at its other turning point: the formula must have
        // the same start.
        let start = formula.motion(self.bits).at_zero();
        let apart = WORKING.difference(&start, &WORKING.fraction(&self.start));
        let size = formula.motion(self.bits).norm() * Bound::power_of_two(-ROUNDING_OF_START);
        if WORKING.distance_from_zero(&apart) > size.value() {
            return Err("a formula that begins elsewhere than the motion");
        }
        self.amplitude_of_law(formula)?;
        law::law_matches_frequency(formula, self.bits).map(|_| ())
    }

    /// Checks that the amplitude among the values of the law is that of the motion, measured from
    /// an equilibrium.
    fn amplitude_of_law(&self, formula: &JudgedFormula) -> Result<(), &'static str> {
        let letter = formula.letters.amplitude;
        let amplitude = formula.values.iter().find(|(name, _)| *name == letter);
        let Some((_, amplitude)) = amplitude else {
            return Ok(());
        };
        let belongs = amplitude.as_number().is_some_and(|amplitude| {
            let place = &self.start - amplitude;
            // An equilibrium that is not a fraction is known to seventeen digits.
            let near = amplitude.abs()
                / Rational::from_integer(Integer::from(1) << ROUNDING_OF_EQUILIBRIUM);
            let force = |place: Rational| {
                let value = self.force.substitute(coordinate(), &Expr::number(place)).ok();
                value.and_then(|value| law::number(&value))
            };
            let is_zero = |ball: &Ball| WORKING.distance_from_zero(ball) <= 0.0;
            match [&place - &near, place.clone(), &place + &near].map(force) {
                [_, Some(middle), _] if is_zero(&middle) => true,
                [Some(left), _, Some(right)] => {
                    !is_zero(&left)
                        && !is_zero(&right)
                        && left.middle.is_negative() != right.middle.is_negative()
                }
                _ => false,
            }
        });
        match belongs {
            true => Ok(()),
            false => Err("a law whose amplitude is not that of the motion"),
        }
    }
}

/// Number of binary digits of the amplitude to which an equilibrium is known.
const ROUNDING_OF_EQUILIBRIUM: usize = 30;

/// Number of binary digits, of the size of the coefficients, to which their sum agrees with the
/// start of the formula: they are doubles, and may cancel.
const ROUNDING_OF_START: i32 = 20;

/// The parts of a certificate whose sizes are checked before anything is computed with them.
struct Sizes<'a> {
    /// Bits of the numbers, and of the approximate inverse.
    bits: [usize; 2],
    sigma: i32,
    highest: usize,
    odd: bool,
    /// The unknown besides the harmonics: `mu` or `1/omega`.
    number: &'a Integer,
    coefficients: &'a [&'a [Integer]],
    inverse: &'a [Vec<Integer>],
    /// The expressions, each with the symbols that it may contain.
    expressions: &'a [(&'a Expr, &'a [Symbol])],
}

impl Sizes<'_> {
    /// Whether no number is too large.
    fn of_numbers(&self) -> Result<(), &'static str> {
        let has_values = |(force, letters): &(&Expr, &[Symbol])| {
            force.symbols().iter().all(|name| letters.contains(name))
        };
        let coefficients = self.coefficients.iter().copied().flatten();
        let all = coefficients.chain([self.number]).chain(self.inverse.iter().flatten());
        let demands = [
            (self.bits.iter().all(|bits| *bits <= MOST_BITS), "more than 224 bits"),
            ((-64..=64).contains(&self.sigma), "a weight of mu beyond 2^64"),
            (
                (1..=HIGHEST_HARMONIC).contains(&self.highest),
                "a block that ends beyond harmonic 400, or has none",
            ),
            (
                !self.odd || self.highest % 2 == 1,
                "odd harmonics, and a block that ends with an even one",
            ),
            (
                self.coefficients.iter().all(|list| list.len() <= 2 * HIGHEST_HARMONIC),
                "more than 800 harmonics",
            ),
            (self.expressions.iter().all(has_values), "a force with letters that have no value"),
            (
                all.into_iter().all(|integer| integer.bits() <= 700),
                "a number of more than 200 digits",
            ),
        ];
        match demands.into_iter().find(|(holds, _)| !holds) {
            Some((_, reason)) => Err(reason),
            None => Ok(()),
        }
    }

    /// Whether the inverse has as many rows and columns as there are unknowns.
    fn of_inverse(&self, unknowns: usize) -> Result<(), &'static str> {
        match self.inverse.len() == unknowns && self.inverse.iter().all(|row| row.len() == unknowns)
        {
            true => Ok(()),
            false => Err("an inverse of another size than the block"),
        }
    }
}

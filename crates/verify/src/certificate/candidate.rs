//! The numbers of a certificate: Newton's iteration from the true motion in doubles, as far as the
//! digits suffice.
//!
//! In: an oscillator, an answer and values. Out: a certificate that has been checked. The theorem
//! trusts nothing here: the numerical motion of verification gives the first harmonics, the inverse
//! of the derivative in doubles gives the steps, and each block that does not prove the motion is
//! followed by a larger one.

use std::f64::consts::TAU;

use nalgebra::DMatrix;
use num_traits::{ToPrimitive as _, Zero as _};

use super::formula::{JudgedFormula, LettersOfLaw};
use super::fourier_series::WORKING;
use super::radii_polynomial::{Correction, NotProved};
use super::theorem::{
    ConservativeProblem, CoordinateHarmonic, correction, derivative_of_block, prove,
};
use super::{Certificate, Certified, HIGHEST_HARMONIC, coordinate, formula, law};
use crate::decimal::neighbours;
use crate::exact::ball::{Ball, Balls};
use crate::exact::bound::Bound;
use crate::exact::rational::from_f64;
use crate::exact::{Integer, Rational};
use crate::expr::{Expr, ExprError};
use crate::method::numbers::NoNumbers;
use crate::numeric::harmonics::Transform;
use crate::oscillator::{Oscillator, OscillatorError};
use crate::solution::{AmplitudeConvention, Solution};
use crate::symbol::Symbol;
use crate::values::Values;
use crate::verify::{self, VerificationError};

/// Binary digits behind the point of the harmonics: thirty-three decimal ones.
pub(super) const BITS: usize = 112;
/// Bits of the entries of the approximate inverse, which need not be exact.
pub(super) const INVERSE_BITS: usize = 56;

/// The reason why there is no certificate. It is no evidence against a formula, unless verification
/// does not find the motion either.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotCertified {
    /// A force that depends on velocity or time, for a motion that is not on a limit cycle.
    #[error(
        "`{0}` depends on the velocity or on time: certificates are of limit cycles, of driven motions and of motions whose force is that of their position alone"
    )]
    NotConservative(String),
    /// A limit cycle of an equation of another form.
    #[error(
        "`{term}` is not linear in the velocity: certificates of limit cycles are of x'' + g(x)*x' + h(x) = 0"
    )]
    NotLienard {
        /// The term that is not linear in the velocity.
        term: String,
        /// The equation of the velocity, where that has this form.
        of_velocity: Option<String>,
    },
    /// A driven motion of an equation of another form.
    #[error(
        "`{0}` is of another form: certificates of driven motions are of x'' + g(x)*x' + h(x) = 0, h with sines and cosines of one drive"
    )]
    NotDriven(String),
    /// Driven or damped coordinates with a term of another form.
    #[error(
        "the equation of {coordinate}'' has `{term}`: certificates of limit cycles and of driven motions of several coordinates are of q'' + G(q)*q' + h(q) = 0, h with sines and cosines of one drive at most"
    )]
    NotCoupledDriven {
        /// The coordinate.
        coordinate: String,
        /// The term, of the acceleration with its sign changed.
        term: String,
    },
    /// A coordinate of an equation of first order.
    #[error("{0}' is given by an equation of first order: certificates are of accelerations")]
    FirstOrder(String),
    /// A damping whose forces are not the rates of functions of the positions.
    #[error(
        "the damping of an equation is not the rate of a function of the positions, as `x*y' + y*x'` is and `x*y'` is not: a proof of a limit cycle or of a driven motion of several coordinates needs that"
    )]
    DampingOfNoFunction,
    /// A coordinate with the name of a wave of the drive.
    #[error(
        "the coordinate {0} has the name of a wave of the drive: in a certificate c and s are its cosine and its sine"
    )]
    WaveAsCoordinate(String),
    /// A parameter without a value.
    #[error("no value of {0}")]
    NoValueOf(String),
    /// A value of a coordinate that is no number.
    #[error("{0} is no number, from which a motion may start")]
    StartOfMotion(String),
    /// A value of something that is no parameter.
    #[error("there is no parameter {0}")]
    NoParameter(String),
    /// A motion from rest that does not come to one of the period of the drive.
    #[error(
        "the motion from rest does not come in 1000 periods of the drive to one that repeats itself after one of them, or a few"
    )]
    NotSettled,
    /// Coupled equations without a drive, a motion of which comes to rest.
    #[error("the motion from rest at {0} comes to rest: it leads to no limit cycle")]
    ComesToRest(String),
    /// Coupled equations without a drive, a motion of which grows without end.
    #[error("the motion from rest at {0} runs away, or to where the equations have no value")]
    RunsAway(String),
    /// Coupled equations without a drive, a motion of which is not periodic at the end.
    #[error(
        "the motion from rest at {0} does not become periodic: it has two frequencies, is irregular, or settles too slowly"
    )]
    NoCycle(String),
    /// A drive whose frequency is not a fraction.
    #[error(
        "the driving frequency {0} is no fraction: a certificate needs to know the period exactly"
    )]
    DrivingFrequency(String),
    /// The formula has no steady motion with an amplitude of its own and a true motion near it.
    #[error(
        "at these values no steady motion of the formula has an amplitude and a true motion near"
    )]
    NoSteadyMotion,
    /// An answer about the transient to a limit cycle.
    #[error(
        "with an amplitude the formula is about the way to the limit cycle, and a certificate is of the cycle"
    )]
    OffCycle,
    /// A motion with more harmonics than a certificate ever has.
    #[error("not certified: the motion has more than {0} harmonics, more than a proof can hold")]
    TooManyHarmonics(usize),
    /// A formula in the amplitude of the first harmonic.
    #[error(
        "the formula is one in the amplitude of the first harmonic, a: a certificate needs to know where exactly the motion starts"
    )]
    Convention,
    /// A start that is not a fraction.
    #[error(
        "x(0) = {0} is no fraction: a certificate needs to know exactly where the motion starts"
    )]
    Start(String),
    /// An amplitude of a mode that is not a fraction.
    #[error("{symbol} = {value} is no fraction: a certificate needs to know the amplitude exactly")]
    Amplitude {
        /// The symbol of the amplitude.
        symbol: String,
        /// Its value.
        value: String,
    },
    /// Coupled equations whose accelerations depend on velocities.
    #[error(
        "{coordinate}'' = -({force}) depends on velocities: certificates of several coordinates are of forces that are those of their positions alone, and of inertia that depends on no position"
    )]
    NotOfPosition {
        /// The coordinate.
        coordinate: String,
        /// The acceleration with its sign changed.
        force: String,
    },
    /// The formula has no motion at these values.
    #[error(transparent)]
    Motion(#[from] NoNumbers),
    /// A formula that cannot be compared with the motion.
    #[error("the formula cannot be judged: it is {0}")]
    Formula(&'static str),
    /// A motion with sines.
    #[error("the motion of the formula is none of cosines alone")]
    Sines,
    /// A motion that verification does not find.
    #[error(transparent)]
    Truth(#[from] VerificationError),
    /// A force whose terms could not be separated, or that had no value.
    #[error(transparent)]
    Oscillator(#[from] OscillatorError),
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// A law that is not an expression in the amplitude.
    #[error(
        "`{0}` is no expression in the amplitude: it has numbers at one amplitude after the other alone"
    )]
    Law(String),
    /// The proof fails for a reason that does not depend on the block.
    #[error("not certified: {0}")]
    NoSeries(NotProved),
    /// The proof fails for every block.
    #[error("not certified: {reason}, with {harmonics} harmonics in the block")]
    NotProved {
        /// The inequality that does not hold.
        reason: NotProved,
        /// Number of harmonics of the last block.
        harmonics: usize,
    },
}

impl NotCertified {
    /// Returns advice on what to do about the refusal, in a sentence; `None` if there is none.
    pub fn help(&self) -> Option<String> {
        let help = match self {
            Self::NotConservative(_) => {
                "a limit cycle is the motion of a formula by lindstedt-poincare or multiple-scales; `simulate` and the verdict of `derive` follow other motions in numbers"
            }
            Self::NotLienard { of_velocity: Some(equation), .. } => {
                return Some(format!(
                    "the velocity is a motion on the limit cycle of `{equation}`, of the same frequency: certify that"
                ));
            }
            Self::NotLienard { .. } => {
                "`simulate` and the verdict of `derive` follow such motions in numbers"
            }
            Self::NotDriven(_) => {
                "`response` and the verdict of `derive` follow such motions in numbers"
            }
            Self::NotCoupledDriven { .. } | Self::FirstOrder(_) | Self::DampingOfNoFunction => {
                "`response` finds such motions in numbers"
            }
            Self::WaveAsCoordinate(_) => "give the coordinate another name",
            Self::NoValueOf(name) => return Some(format!("add --at {name}=...")),
            Self::NotSettled => {
                "more damping, another frequency, or another start by values of the coordinates, --at x=2; `response` finds motions that repeat themselves"
            }
            Self::ComesToRest(_) | Self::RunsAway(_) | Self::NoCycle(_) => {
                "values of the coordinates are another start, --at x=2; `response` finds the limit cycles of a range in numbers"
            }
            Self::DrivingFrequency(_) => "give it as a decimal or a fraction",
            Self::NoSteadyMotion => {
                "`derive` with --at lists the steady motions; `response` finds those of a range"
            }
            Self::OffCycle => "leave the amplitude out",
            Self::Law(_) => "without a range it is certified at one amplitude",
            Self::Motion(NoNumbers::Missing(_) | NoNumbers::Driven | NoNumbers::Equation(_)) => {
                return None;
            }
            Self::Motion(_) | Self::Formula(_) | Self::Sines => {
                "--no-formula proves the motion alone: that it exists, and its frequency"
            }
            Self::Start(_) => {
                "give the amplitude as a decimal or a fraction, and an equilibrium that is one"
            }
            Self::Amplitude { .. } => "give the amplitude as a decimal or a fraction",
            Self::NotOfPosition { .. } => {
                "`derive` with --at judges such modes by shooting, in numbers"
            }
            Self::NoSeries(_) => {
                "sums, products, powers, sin, cos, tan, sinh, cosh, tanh, exp, log and atan where they are smooth along the whole motion"
            }
            Self::TooManyHarmonics(_) => {
                "a smaller parameter: where a motion jumps, it has many harmonics"
            }
            Self::NotProved { .. } => {
                "a smaller amplitude or parameter: near the edge of a well, or where a motion turns sharply, it has more harmonics than a proof can hold; or units in which frequency and amplitude are nearer to one"
            }
            _ => return None,
        };
        Some(help.to_owned())
    }
}

/// A certificate of the motion that a formula is about, and what it proves of the formula.
///
/// # Errors
/// [`NotCertified`].
pub fn certify(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
) -> Result<(Certificate, Certified), NotCertified> {
    certified_motion(oscillator, solution, at, true)
}

/// A certificate of the motion that a formula is about, without the formula: the formula may have
/// no value there.
///
/// # Errors
/// [`NotCertified`].
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::{certify_motion, check};
/// use lindstedt::{Options, Oscillator, solve};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options { order: Some(2), ..Options::default() })?;
/// // omega^2 = 1 - A^2/8 is negative there.
/// let (certificate, certified) = certify_motion(&pendulum, &solution, &"A = 3".parse()?)?;
/// assert!(certified.formula.is_none() && check(&certificate) == Ok(certified));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn certify_motion(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
) -> Result<(Certificate, Certified), NotCertified> {
    certified_motion(oscillator, solution, at, false)
}

fn certified_motion(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
    with_formula: bool,
) -> Result<(Certificate, Certified), NotCertified> {
    let _letters = oscillator.letters().in_force();
    let question = ProofTarget::new(oscillator, solution, at)?;
    let judged = match with_formula {
        true => Some(judged(solution, at, BITS)?),
        false => None,
    };
    if judged.as_ref().is_some_and(|formula| !formula.sines.is_empty()) {
        return Err(NotCertified::Sines);
    }
    let samples = verify::true_motion(oscillator, solution, at)?;
    let (mu, harmonics) = from_samples(&samples, question.odd);
    let mut certificate = question.certificate(mu, &harmonics, judged);
    certificate.well_formed_formula().map_err(NotCertified::Formula)?;
    // With many harmonics few steps suffice; the number that a proof needs is found later.
    certificate.highest = (2 * harmonics.len()).clamp(15, HIGHEST_HARMONIC / 2) | 1;
    refine(&mut certificate, Bound::ZERO)
        .map_err(|reason| not_proved(reason, certificate.problem().block().len()))?;
    let mut reason = NotProved::NoContraction(Bound::UNKNOWN);
    for highest in blocks(harmonics.len()) {
        certificate.highest = highest;
        match proved(&mut certificate) {
            Ok(certified) => return Ok((certificate, certified)),
            Err(error @ NotProved::NoValue(_)) => {
                return Err(not_proved(error, certificate.problem().block().len()));
            }
            Err(error) => reason = error,
        }
    }
    Err(not_proved(reason, certificate.problem().block().len()))
}

pub(super) fn not_proved(reason: NotProved, harmonics: usize) -> NotCertified {
    match reason {
        NotProved::NoValue(_) => NotCertified::NoSeries(reason),
        _ => NotCertified::NotProved { reason, harmonics },
    }
}

/// The last harmonics of the blocks that are tried, all odd: from about half of the harmonics that
/// are visible in double precision upwards.
pub(super) fn blocks(seen: usize) -> impl Iterator<Item = usize> {
    let first = (seen / 2).max(5) | 1;
    let sizes = std::iter::successors(Some(first), |size| Some((size * 3 / 2) | 1));
    sizes.take_while(|size| *size < HIGHEST_HARMONIC).take(8)
}

/// A block of a proof: its last harmonic, and whether it has odd harmonics alone.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockChoice {
    pub(super) highest: usize,
    pub(super) odd: bool,
}

/// The first proof in blocks of rising size. Where the motion has odd harmonics alone, a few blocks of
/// all harmonics are tried first: a proof in them leaves nothing open, one among the odd ones says
/// nothing of motions with even ones beside it.
pub(super) fn first_proof(
    odd: bool,
    seen: usize,
    largest: impl Fn(bool) -> usize,
    mut attempt: impl FnMut(BlockChoice) -> Result<Certified, NotProved>,
) -> Result<Certified, NotProved> {
    /// Number of blocks of all harmonics that are tried before those of odd ones.
    const ATTEMPTS: usize = 3;
    let classes: &[(bool, usize)] = match odd {
        true => &[(false, ATTEMPTS), (true, usize::MAX)],
        false => &[(false, usize::MAX)],
    };
    let mut reason = NotProved::NoContraction(Bound::UNKNOWN);
    for &(odd, attempts) in classes {
        let most = largest(odd);
        let sizes = blocks(seen).take_while(|highest| *highest <= most);
        for highest in sizes.take(attempts) {
            match attempt(BlockChoice { highest, odd }) {
                Err(error) if !matches!(error, NotProved::NoValue(_)) => reason = error,
                found => return found,
            }
        }
    }
    Err(reason)
}

/// The largest odd number that is neither above one number nor another.
pub(super) fn odd_below(one: usize, other: usize) -> usize {
    let least = one.min(other).max(1);
    if least % 2 == 1 { least } else { least - 1 }
}

/// The motion to be proved: `x'' + force = 0` from rest at `start`.
struct ProofTarget {
    force: Expr,
    start: Rational,
    odd: bool,
}

impl ProofTarget {
    fn new(
        oscillator: &Oscillator,
        solution: &Solution,
        at: &Values,
    ) -> Result<Self, NotCertified> {
        let parts = oscillator.parts()?;
        for part in [parts.damping, parts.inertia, parts.forcing] {
            if !part.is_zero() {
                return Err(NotCertified::NotConservative(part.to_string()));
            }
        }
        if solution.amplitude != AmplitudeConvention::Initial {
            return Err(NotCertified::Convention);
        }
        let (values, _) = at.split(&oscillator.parameters);
        let force = oscillator.force.substitute_all(&values)?;
        let (amplitude, _) = at.split(&[solution.amplitude.symbol()]);
        let amplitude = amplitude.into_values().next().unwrap_or_else(Expr::one);
        let equilibrium = solution.equilibrium.substitute_all(&values)?;
        let start = &equilibrium + &amplitude;
        let start =
            start.as_number().ok_or_else(|| NotCertified::Start(start.to_string()))?.clone();
        let force = written_out(
            force.substitute(oscillator.coordinate, &Expr::from(coordinate()))?,
            &[coordinate()],
        )?;
        // In one of two wells beside each other a motion has all harmonics, whatever the symmetry
        // of the force.
        let odd = equilibrium.is_zero() && super::force::is_odd(&force, &[coordinate()])?;
        Ok(Self { force, start, odd })
    }

    fn certificate(
        self,
        mu: f64,
        harmonics: &[f64],
        formula: Option<JudgedFormula>,
    ) -> Certificate {
        Certificate {
            force: self.force,
            start: self.start,
            odd: self.odd,
            bits: BITS,
            mu: units(mu, BITS),
            coefficients: harmonics.iter().map(|value| units(*value, BITS)).collect(),
            highest: 1,
            inverse_bits: INVERSE_BITS,
            inverse: vec![],
            sigma: 0,
            claim: Rational::zero(),
            formula,
        }
    }
}

/// A polynomial written out, as it is in a document; anything else as it is.
pub(super) fn written_out(force: Expr, coordinates: &[Symbol]) -> Result<Expr, ExprError> {
    let written = force.to_polynomial(&mut |_| None)?.filter(|sum| {
        let ranges = coordinates.iter().filter_map(|name| sum.exponent_range(*name));
        ranges.into_iter().all(|range| range.0 >= 0)
    });
    Ok(written.as_ref().map_or(force, Expr::from))
}

/// A double as an integer number of units of `2^-bits`.
pub(super) fn units(value: f64, bits: usize) -> Integer {
    from_f64(value).map_or_else(Integer::zero, |value| Balls { bits }.fraction(&value).middle)
}

/// The formula with its numbers; nothing is claimed yet. A motion of cosines alone has an empty
/// list of sines.
pub(super) fn judged(
    solution: &Solution,
    at: &Values,
    bits: usize,
) -> Result<JudgedFormula, NotCertified> {
    let motion = solution.motion_at(at)?;
    let displacement = motion.displacement();
    let harmonics = 0..=displacement.highest_harmonic();
    let sines: Vec<f64> = harmonics.clone().map(|k| displacement.sine(k).mean().0).collect();
    let length = sines.iter().rposition(|sine| *sine != 0.0).map_or(0, |last| last + 1);
    let cosines: Vec<f64> = harmonics.map(|k| displacement.cosine(k).mean().0).collect();
    let mut formula = without_claims([&cosines, &sines[..length]], bits);
    (formula.law, formula.values) = law::of_frequency(solution, at);
    formula.frequency = units(motion.frequency(), bits);
    // If the law can be evaluated exactly from its text, that value is the frequency of the
    // formula; the double of it may have lost digits.
    match law::frequency(&formula) {
        Some(exact) if is_near(&exact, motion.frequency()) => {
            formula.frequency = Balls { bits }.converted(&exact, WORKING).middle;
        }
        Some(_) => formula.law = solution.title(),
        None => {}
    }
    Ok(formula)
}

/// Returns whether a ball lies near a double.
pub(super) fn is_near(exact: &Ball, double: f64) -> bool {
    const AGREEMENT: f64 = 1e-9;
    (WORKING.nearest(exact) - double).abs() <= AGREEMENT * double.abs()
}

/// A formula of which nothing is claimed yet, its cosine and sine coefficients in units; without a
/// law, and without a frequency.
pub(super) fn without_claims([cosines, sines]: [&[f64]; 2], bits: usize) -> JudgedFormula {
    let in_units = |values: &[f64]| values.iter().map(|value| units(*value, bits)).collect();
    let nothing = || [Rational::zero(), Rational::zero()];
    JudgedFormula {
        law: String::new(),
        letters: LettersOfLaw::in_force(),
        values: Values::default(),
        frequency: Integer::zero(),
        coefficients: in_units(cosines),
        sines: in_units(sines),
        others: vec![],
        deviation: nothing(),
        frequency_error: nothing(),
        drift: nothing(),
        amplitude_error: nothing(),
    }
}

/// Relative size below which the numbers of a Runge-Kutta orbit are integration error.
pub(super) const NOISE: f64 = 1e-11;

/// `1/omega^2` and the cosine coefficients of one period.
fn from_samples(samples: &[verify::TimedState], odd: bool) -> (f64, Vec<f64>) {
    let count = samples.len() - 1;
    let period = samples[count].0;
    let places: Vec<f64> = samples[..count].iter().map(|(_, x, _)| *x).collect();
    let mut harmonics =
        Transform::new(count).harmonics(&places, HIGHEST_HARMONIC.min(count / 2)).cosines;
    // The coefficient of the constant was twice the mean.
    harmonics[0] /= 2.0;
    if odd {
        harmonics.iter_mut().step_by(2).for_each(|even| *even = 0.0);
    }
    let largest = harmonics.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    while harmonics.len() > 2 && harmonics.last().is_some_and(|last| last.abs() < NOISE * largest) {
        harmonics.pop();
    }
    ((period / TAU).powi(2), harmonics)
}

/// Checks a certificate with its block, and enters the proved values as claims.
fn proved(certificate: &mut Certificate) -> Result<Certified, NotProved> {
    certificate.inverse = inverse(&certificate.problem())?;
    certificate.sigma = weight(&certificate.inverse);
    let proof = prove(certificate.problem())?;
    let [_, claim] = claimed(proof.radius.value());
    certificate.claim = claim;
    let certified = certificate.certified(proof)?;
    claim_errors(certificate.formula.as_mut(), &certified);
    Ok(certified)
}

/// The neighbouring decimals of three digits; zero for infinity, a claim that does not hold.
pub(super) fn claimed(value: f64) -> [Rational; 2] {
    neighbours(&from_f64(value).unwrap_or_default(), 3)
}

/// Enters the proved errors of a formula as its claims.
pub(super) fn claim_errors(formula: Option<&mut JudgedFormula>, certified: &Certified) {
    let Some((formula, errors)) = formula.zip(certified.formula.as_ref()) else {
        return;
    };
    let both = |range: formula::SizeBounds| {
        let ([lower, _], [_, upper]) = (claimed(range.lower), claimed(range.upper));
        [lower, upper]
    };
    formula.deviation = both(errors.deviation);
    formula.frequency_error = both(errors.frequency);
    formula.drift = both(errors.drift);
    formula.amplitude_error = both(errors.amplitude.unwrap_or_default());
}

/// The inverse of the derivative on the block, in doubles.
pub(super) fn inverse(problem: &ConservativeProblem) -> Result<Vec<Vec<Integer>>, NotProved> {
    let rows = derivative_of_block(problem)?;
    inverted(DMatrix::from_fn(rows.len(), rows.len(), |row, column| rows[row][column]))
}

/// The inverse of a matrix, in units.
pub(super) fn inverted(derivative: DMatrix<f64>) -> Result<Vec<Vec<Integer>>, NotProved> {
    let size = derivative.nrows();
    let inverse = derivative.try_inverse().ok_or(NotProved::NoContraction(Bound::UNKNOWN))?;
    let row =
        |row: usize| (0..size).map(|column| units(inverse[(row, column)], INVERSE_BITS)).collect();
    Ok((0..size).map(row).collect())
}

/// Newton's iteration with one inverse, until a step is smaller than `near` or no smaller than the
/// one before.
pub(super) fn refine(certificate: &mut Certificate, near: Bound) -> Result<(), NotProved> {
    let bits = certificate.bits;
    certificate.inverse = inverse(&certificate.problem())?;
    let step = |certificate: &Certificate| correction(certificate.problem());
    iterate(certificate, near.max(few_units(bits)), step, |certificate, step| {
        let block = certificate.problem().block();
        let mut coefficients = [&mut certificate.coefficients];
        subtract_step(&mut certificate.mu, &mut coefficients, &block, bits, step);
    })
}

/// Subtracts a step of Newton's iteration from `mu` and the coefficients of each coordinate.
pub(super) fn subtract_step(
    mu: &mut Integer,
    coefficients: &mut [&mut Vec<Integer>],
    block: &[CoordinateHarmonic],
    bits: usize,
    step: &Correction<CoordinateHarmonic>,
) {
    let short = |ball| Balls { bits }.converted(ball, WORKING).middle;
    *mu -= short(&step.block[0]);
    let corrections = block.iter().zip(&step.block[1..]);
    for (wave, ball) in corrections.chain(step.beyond.iter().map(|(wave, ball)| (wave, ball))) {
        subtract(coefficients[wave.coordinate], wave.harmonic, short(ball));
    }
    for list in coefficients {
        shorten(list);
    }
}

/// A bound of some units in the last place of numbers with this many bits.
pub(super) fn few_units(bits: usize) -> Bound {
    Bound::power_of_two(-(bits as i32)) * Bound::exactly(64.0)
}

/// Newton's iteration, until a step is smaller than `near` or no smaller than the one before.
pub(super) fn iterate<Candidate, Place>(
    candidate: &mut Candidate,
    near: Bound,
    correction: impl Fn(&Candidate) -> Result<Correction<Place>, NotProved>,
    subtract: impl Fn(&mut Candidate, &Correction<Place>),
) -> Result<(), NotProved> {
    /// Largest number of steps of an iteration that gains one digit per step.
    const STEPS: usize = 40;
    let mut before = Bound::UNKNOWN;
    for _ in 0..STEPS {
        let step = correction(candidate)?;
        let all = step.block.iter().chain(step.beyond.iter().map(|(_, ball)| ball));
        let size: Bound = all.map(|ball| WORKING.magnitude(ball)).sum();
        if size >= before || size == Bound::UNKNOWN {
            break;
        }
        before = size;
        subtract(candidate, &step);
        if size < near {
            break;
        }
    }
    Ok(())
}

/// Subtracts from a coefficient, which need not be there yet.
pub(super) fn subtract(coefficients: &mut Vec<Integer>, harmonic: usize, correction: Integer) {
    if coefficients.len() <= harmonic {
        coefficients.resize(harmonic + 1, Integer::zero());
    }
    coefficients[harmonic] -= correction;
}

/// Removes trailing coefficients without significant digits, and those beyond the greatest length.
pub(super) fn shorten(coefficients: &mut Vec<Integer>) {
    while coefficients.len() > 2
        && (coefficients.len() > 2 * HIGHEST_HARMONIC
            || coefficients.last().is_some_and(|last| last.bits() < 4))
    {
        coefficients.pop();
    }
}

/// The weight, as a power of two, with which an error of the unknown frequency counts as much as
/// the errors of the harmonics that it causes.
pub(super) fn weight(inverse: &[Vec<Integer>]) -> i32 {
    let balls = Balls { bits: INVERSE_BITS };
    let number = |units: &Integer| {
        let ball = balls.dyadic(units, INVERSE_BITS);
        balls.nearest(&ball).abs()
    };
    let of_number = number(&inverse[0][0]);
    let of_harmonics: f64 = inverse[1..].iter().map(|row| number(&row[0])).sum();
    let ratio = (of_harmonics / of_number).log2().round();
    ratio.to_i32().map_or(0, |ratio| ratio.clamp(-20, 20))
}

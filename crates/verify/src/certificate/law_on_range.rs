//! The largest error of a frequency law on a whole range, proved from both sides.
//!
//! The motion `x'' + f(x; p) = 0` released at rest from a turns at b, where `V(b) = V(a)`, and half of
//! its time is a mean over the angle of `x = m + r cos(theta)`, `m = (a + b)/2`, `r = (a - b)/2`:
//!
//! ```text
//! 1/omega = mean over theta of G^(-1/2),      G = 2 (V(a) - V(x))/(r^2 sin^2(theta))
//! f(m + r cos(theta)) = sum_k F_k cos(k theta):   r G = F_1 + 4 sum_{l >= 1} l cos(l theta) sum_{k = l + 1, l + 3, ...} F_k/(k^2 - 1)
//! V(a) - V(b) = 2 r (F_0 - sum_{q >= 1} F_2q/(4 q^2 - 1)),    of an odd force m = 0
//! ```
//!
//! The sum of the sizes of the coefficients of `r G` is at most 4/3 of that of f, so that the tail of f
//! is a bound for that of `r G`. The mean is the constant of the series of `G^(-1/2)`, a function of
//! `FourierSeries`. On each of some pieces of the range `1/omega` is a polynomial through sixteen of
//! its values, with a remainder from a bound on a disc of complex values of the variable about the
//! piece. On an interval `|v - m| <= h` the quotient `q = law/truth` is within `h max |q'|` of its value
//! in the middle, and intervals are halved until that is within the claim; a range to infinity ends with
//! pieces of `r = 1/p`, in which the powers of r are kept apart.
//!
//! With a mass M(x) in `M x'' + (dM/dx) x'^2/2 + f = 0` the mean is that of `(M/G)^(1/2)`. The duration of a
//! contact is such a mean too: see `contact`.
//!
//! In: a force, a law, a range and a claim. Out: bounds of the largest `|q - 1|`. A piece costs some
//! seventeen series of `G^(-1/2)`, an interval the law and a polynomial of degree 15; there are the more
//! intervals the smaller the error is, as its root.
//!
//! Sources: L. D. Landau, E. M. Lifshitz, Mechanics, section 11, for the quarter period; L. N. Trefethen,
//! Approximation Theory and Approximation Practice, SIAM 2013, chapter 11, for the remainder (Hermite's
//! integral); R. E. Moore, Interval Analysis, Prentice-Hall 1966, chapter 6, for the mean value form.

mod contact;
mod inverse_frequency;
mod jet;

use num_traits::{One as _, Signed as _, Zero as _};

use super::force::NoValue;
use super::fourier_series::WORKING;
use super::{CheckError, coordinate};
use crate::decimal::decimal;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::rational::{from_f64, to_f64};
use crate::exact::{Integer, Rational};
use crate::expr::{Expr, ExprError};
use crate::interrupt::Supervision;
use crate::symbol::Symbol;
use contact::ContactMean;
pub use contact::HuntCrossleyForce;
use inverse_frequency::{ForceOnRange, PiecePolynomial, TruthPiece};
use jet::{Jet, ScaledJet, Variable, law_along, widened};

/// The quantity that a law gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawQuantity {
    /// The angular frequency.
    Frequency,
    /// Its square.
    FrequencySquared,
    /// The period over 2 pi.
    Period,
    /// The duration of a contact over that without damping and with the same speed at the touch.
    ContactTime,
}

impl LawQuantity {
    /// The power of omega that the quantity is, or of T_0/T.
    pub const fn power(self) -> i32 {
        match self {
            Self::Frequency => 1,
            Self::FrequencySquared => 2,
            Self::Period | Self::ContactTime => -1,
        }
    }

    /// Its name: `omega`, `omega^2`, `T/(2*pi)` or `T/T_0`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Frequency => "omega",
            Self::FrequencySquared => "omega^2",
            Self::Period => "T/(2*pi)",
            Self::ContactTime => "T/T_0",
        }
    }

    /// All quantities.
    pub const ALL: [Self; 4] =
        [Self::Frequency, Self::FrequencySquared, Self::Period, Self::ContactTime];
}

/// The letter of the coefficient of restitution in the law of a contact.
pub fn restitution() -> Symbol {
    Symbol::new("e")
}

/// The start of the motion, at rest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StartOfLaw {
    /// The variable of the law is the amplitude.
    Variable,
    /// The amplitude is this number, and the variable is a parameter of the force.
    Fixed(Rational),
}

/// A law on a range, and what is claimed of its error. The numbers may be anything: [`check_law`]
/// trusts none of them.
#[derive(Clone, Debug, PartialEq)]
pub struct LawCertificate {
    /// `f` of `x'' + f = 0`, in the symbol [`x`](coordinate) and the variable; of a contact
    /// `x^n (1 + c x')`, with numbers.
    pub force: Expr,
    /// The mass M of `M x'' + (dM/dx) x'^2/2 + f = 0` where it depends on the position.
    pub mass: Option<Expr>,
    /// The amplitude or the parameter on which the law depends; of a contact the speed at the touch.
    pub variable: Symbol,
    /// The start of the motion.
    pub start: StartOfLaw,
    /// The quantity.
    pub quantity: LawQuantity,
    /// The law as an expression in the variable; of a contact in its [`restitution`] as well.
    pub law: Expr,
    /// The lower end of the range, not negative.
    pub from: Rational,
    /// The upper end; `None` for infinity.
    pub to: Option<Rational>,
    /// The place at which the error is at least the lower claim.
    pub worst: Rational,
    /// Claimed bounds of the largest `|law/truth - 1|` on the range.
    pub claim: [Rational; 2],
}

/// Bounds of the largest error of a law on its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawError {
    /// The largest error is at least this.
    pub lower: f64,
    /// The largest error is at most this.
    pub upper: f64,
}

/// The reason why a law is not proved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawNotProved {
    /// The motion does not swing about zero.
    #[error(
        "a proof on a range is of motions about an equilibrium that is a number, and `{0}` is not zero at x = 0"
    )]
    NotCentred(String),
    /// Letters or ends that do not belong together.
    #[error("a proof on a range is of a force of the position and the variable alone: {0}")]
    Malformed(&'static str),
    /// The force is not that of a contact that loses energy.
    #[error(
        "the time of a contact is proved for forces x^n*(1 + c*x') with a small fraction n and a number c: not for {0}"
    )]
    NoContact(String),
    /// A part of the force or of the law has no enclosure.
    #[error("`{0}` has no value over cosine series")]
    NoValue(String),
    /// A derivative of the force is too large to be written.
    #[error(transparent)]
    Derivative(#[from] ExprError),
    /// The law and the truth grow with different powers of the variable.
    #[error(
        "the law and the true frequency grow with different powers of {0}, so that no error bounds it to infinity"
    )]
    Growth(Symbol),
    /// The motion is a limit cycle.
    #[error("a proof on a range is of motions that conserve energy, not of a limit cycle")]
    LimitCycle,
    /// The motion is one of several coordinates.
    #[error("a proof on a range is of one coordinate, not of a mode of several")]
    Mode,
    /// At this place the error is neither proved to be within the claim nor beyond it.
    #[error("at {0} the error is not proved to be within its bound")]
    Open(String),
    /// The computation was interrupted.
    #[error("the proof was interrupted")]
    Stopped,
}

impl From<NoValue> for LawNotProved {
    fn from(NoValue(part): NoValue) -> Self {
        Self::NoValue(part)
    }
}

/// Checks the claims of a certificate.
///
/// # Errors
/// [`CheckError`].
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::certificate::{LawCertificate, LawQuantity, StartOfLaw, check_law};
/// use lindstedt::exact::ratio;
///
/// let mut law = LawCertificate {
///     force: "sin(x)".parse()?,
///     mass: None,
///     variable: "A".into(),
///     start: StartOfLaw::Variable,
///     quantity: LawQuantity::Period,
///     law: "4/(1 + sqrt(cos(A/2)))^2".parse()?,
///     from: ratio(0, 1),
///     to: Some(ratio(14, 5)),
///     worst: ratio(14, 5),
///     claim: [ratio(757, 100_000), ratio(758, 100_000)],
/// };
/// assert!(check_law(&law)?.lower > 0.00757);
/// law.claim[1] = ratio(757, 100_000);
/// assert!(check_law(&law).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_law(certificate: &LawCertificate) -> Result<LawError, CheckError> {
    certificate.well_formed().map_err(CheckError::Malformed)?;
    let unproved = |error: LawNotProved| CheckError::Law(error);
    let supervision = Supervision::default();
    let truth = TrueFrequency::new(certificate, supervision).map_err(unproved)?;
    let lower = truth.least_error(certificate).map_err(unproved)?;
    if from_f64(lower).is_none_or(|lower| lower < certificate.claim[0]) {
        return Err(CheckError::ClaimedMore { what: "the largest error", proved: lower });
    }
    let upper = truth.largest_error(certificate, supervision).map_err(unproved)?;
    Ok(LawError { lower, upper })
}

impl LawCertificate {
    fn well_formed(&self) -> Result<(), &'static str> {
        let is_known = |expression: &Expr, letters: &[Symbol]| {
            expression.symbols().iter().all(|name| letters.contains(name))
        };
        let ends = match &self.to {
            Some(to) => self.from < *to && self.worst <= *to,
            None => true,
        };
        let depends = |mass: &Expr| mass.contains(self.variable);
        let is_moving = self.mass.as_ref().is_some_and(depends);
        let is_contact = self.quantity == LawQuantity::ContactTime;
        let depends_on_variable = self.force.contains(self.variable);
        let [of_force, of_law] = match is_contact {
            true => [coordinate().derivative(), restitution()],
            false => [self.variable; 2],
        };
        let start = match &self.start {
            StartOfLaw::Variable => self.to.is_some() && !depends_on_variable,
            StartOfLaw::Fixed(start) => start.is_positive() && !is_contact,
        };
        let demands = [
            (
                ends && !self.from.is_negative() && self.worst >= self.from,
                "an empty range, or a worst place outside of it",
            ),
            (self.variable != coordinate(), "a variable that is the coordinate"),
            (
                !is_contact || self.variable != restitution(),
                "a variable with the letter of the restitution",
            ),
            (
                is_known(&self.force, &[coordinate(), self.variable, of_force]),
                "a force with letters that have no value",
            ),
            (
                self.mass.as_ref().is_none_or(|mass| {
                    is_known(mass, &[coordinate(), self.variable]) && !is_contact
                }),
                "a mass with letters that have no value, or a contact with one",
            ),
            (
                !is_moving || self.start != StartOfLaw::Variable && self.to.is_some(),
                "a mass that depends on the amplitude, or on a parameter that goes to infinity",
            ),
            (
                is_known(&self.law, &[self.variable, of_law]),
                "a law with letters that have no value",
            ),
            (
                start,
                "a start that is not positive, or an amplitude that goes to infinity or is a parameter",
            ),
        ];
        match demands.into_iter().find(|(holds, _)| !holds) {
            Some((_, reason)) => Err(reason),
            None => Ok(()),
        }
    }
}

/// The true frequency on a whole range, enclosed.
pub struct TrueFrequency {
    /// In the variable, and in r = 1/p.
    near: ForceOnRange,
    far: Option<ForceOnRange>,
    near_pieces: Vec<TruthPiece>,
    far_pieces: Vec<TruthPiece>,
}

/// The largest degree of a force in a parameter that goes to infinity.
const MOST_GROWTH: u32 = 12;

impl TrueFrequency {
    /// The true frequency on the range of a certificate; its law is not looked at.
    ///
    /// # Errors
    /// A motion about another equilibrium than zero, or a part of the range on which none is proved.
    pub fn new(
        certificate: &LawCertificate,
        supervision: Supervision,
    ) -> Result<Self, LawNotProved> {
        let LawCertificate { force, variable, start, .. } = certificate;
        certificate.well_formed().map_err(LawNotProved::Malformed)?;
        if certificate.quantity == LawQuantity::ContactTime {
            return Self::of_contact(certificate, supervision);
        }
        let at_zero = force.substitute(coordinate(), &Expr::zero())?.expand()?;
        if !at_zero.is_zero() {
            return Err(LawNotProved::NotCentred(force.to_string()));
        }
        let mass = certificate.mass.as_ref();
        let near = ForceOnRange::new(start, *variable, force.clone(), 0, false)?.with_mass(mass);
        let (from, one) = (&certificate.from, Rational::one());
        let (near_pieces, far, far_pieces) = match &certificate.to {
            Some(to) => (near.pieces(from, to, supervision)?, None, vec![]),
            None => {
                let far = Self::far(certificate)?.with_mass(mass);
                let pieces = far.pieces(&Rational::zero(), &from.max(&one).recip(), supervision)?;
                let near_pieces = match *from < one {
                    true => near.pieces(from, &one, supervision)?,
                    false => vec![],
                };
                (near_pieces, Some(far), pieces)
            }
        };
        Ok(Self { near, far, near_pieces, far_pieces })
    }

    /// T/T_0 and the restitution of the contact of a certificate.
    fn of_contact(
        certificate: &LawCertificate,
        supervision: Supervision,
    ) -> Result<Self, LawNotProved> {
        let no_contact = || LawNotProved::NoContact(certificate.force.to_string());
        let contact = HuntCrossleyForce::of(&certificate.force, coordinate())?;
        let contact = contact.ok_or_else(no_contact)?;
        let damping = contact.damping.as_number().ok_or_else(no_contact)?;
        let mean = ContactMean::new(&contact.exponent, damping).ok_or_else(no_contact)?;
        let near = ForceOnRange::of_contact(mean, certificate.variable)?;
        let to = certificate.to.as_ref().ok_or_else(no_contact)?;
        let near_pieces = near.pieces(&certificate.from, to, supervision)?;
        Ok(Self { near, far: None, near_pieces, far_pieces: vec![] })
    }

    /// `1/omega` at a place of a bounded range, or T/T_0 and the restitution, to the digits of a double.
    pub fn at(&self, place: f64) -> Option<[f64; 2]> {
        let exact = from_f64(place)?;
        let distance = |piece: &TruthPiece| (&exact - &piece.middle).abs() / &piece.half;
        let piece = self.near_pieces.iter().min_by_key(|piece| distance(piece))?;
        let e = WORKING.fraction(&((&exact - &piece.middle) / &piece.half));
        let value = |own: &PiecePolynomial| WORKING.nearest(&own.at(&e, &piece.half).value);
        let restitution = piece.restitution.as_ref().map_or(f64::NAN, value);
        Some([value(&piece.truth), restitution])
    }

    /// The force in `r = 1/p`, times the power of r with which it has a value at zero.
    fn far(certificate: &LawCertificate) -> Result<ForceOnRange, LawNotProved> {
        let name = certificate.variable;
        let variable = Expr::from(name);
        let inverse = Expr::divide(&Expr::one(), &variable)?;
        let force = certificate.force.substitute(name, &inverse)?;
        for power in 0..=MOST_GROWTH {
            let scaled = (&variable.integer_power(i64::from(power))? * &force).expand()?;
            if scaled.substitute(name, &Expr::zero()).is_ok_and(|limit| !limit.is_zero()) {
                return ForceOnRange::new(&certificate.start, name, scaled, power, true);
            }
        }
        Err(LawNotProved::Growth(name))
    }

    /// An upper bound of the largest error of the law of a certificate on this range.
    ///
    /// # Errors
    /// A place at which the error is not proved to be within the claim.
    pub fn largest_error(
        &self,
        certificate: &LawCertificate,
        supervision: Supervision,
    ) -> Result<f64, LawNotProved> {
        let bound = not_above(&certificate.claim[1]);
        let mut largest = 0.0_f64;
        let near = self.near_pieces.iter().map(|piece| (&self.near, piece));
        let far =
            self.far.iter().flat_map(|far| self.far_pieces.iter().map(move |piece| (far, piece)));
        for (force, piece) in near.chain(far) {
            largest = largest.max(piece.largest_error(force, certificate, bound, supervision)?);
        }
        Ok(largest)
    }

    /// A lower bound of the error of the law of a certificate at its worst place.
    ///
    /// # Errors
    /// No value there.
    pub fn least_error(&self, certificate: &LawCertificate) -> Result<f64, LawNotProved> {
        let no_value = || LawNotProved::NoValue(certificate.law.to_string());
        let place = WORKING.fraction(&certificate.worst);
        let begins_at_rest = certificate.start == StartOfLaw::Variable && place.is_zero();
        let truth = match begins_at_rest {
            true => self.near.at_rest()?,
            false => self.near.truth(&place)?,
        };
        let mut truth = truth.into_iter().map(Jet::constant);
        let mut variable = Variable::at(&certificate.worst);
        let (truth, e) = (truth.next().ok_or_else(no_value)?, truth.next());
        variable.restitution = e;
        let quotient =
            quotient(certificate, &self.near, &truth, &variable)?.ok_or_else(no_value)?;
        let error = WORKING.difference(&quotient.value, &WORKING.integer(1));
        Ok(WORKING.distance_from_zero(&error).max(0.0))
    }
}

/// A double that is no larger than a fraction.
fn not_above(value: &Rational) -> f64 {
    let nearest = to_f64(value);
    match from_f64(nearest) {
        Some(exact) if exact <= *value => nearest,
        _ => nearest.next_down(),
    }
}

/// `law/truth` from `1/omega` on an interval of the variable; `None` where it has no value.
fn quotient(
    certificate: &LawCertificate,
    force: &ForceOnRange,
    inverse_frequency: &Jet,
    variable: &Variable,
) -> Result<Option<Jet>, LawNotProved> {
    let law = law_along(&certificate.law, certificate.variable, variable, force.is_far)?;
    let power = certificate.quantity.power();
    // q = law (1/omega)^n, with (1/omega) = r^(d/2) I.
    let exponent = Rational::new((i64::from(force.power) * i64::from(power)).into(), 2.into());
    let whole = Rational::from_integer(power.into());
    let Some(truth) = inverse_frequency.to_power(&whole) else { return Ok(None) };
    let scaled = ScaledJet { power: &law.power + exponent, jet: law.jet.times(&truth) };
    match scaled.power.is_negative() && !variable.from.is_positive() {
        true => Err(LawNotProved::Growth(certificate.variable)),
        false => Ok(scaled.unscaled(variable)),
    }
}

impl TruthPiece {
    /// An upper bound of the error of a law on this piece, which is halved until that is within a
    /// bound.
    fn largest_error(
        &self,
        force: &ForceOnRange,
        certificate: &LawCertificate,
        bound: f64,
        supervision: Supervision,
    ) -> Result<f64, LawNotProved> {
        /// The most halvings of a piece, and the most parts of it.
        const DEEPEST: u32 = 40;
        const MOST: usize = 200_000;
        let two = Integer::from(2);
        let mut open = vec![(-Rational::one(), Rational::one(), 0)];
        let (mut largest, mut tried) = (0.0_f64, 0);
        while let Some((low, high, depth)) = open.pop() {
            tried += 1;
            if tried % 256 == 0 && supervision.interrupt.is_requested() {
                return Err(LawNotProved::Stopped);
            }
            match self.error_between(force, certificate, [&low, &high]) {
                Ok(error) if error <= bound => largest = largest.max(error),
                Err(error @ LawNotProved::Growth(_)) => return Err(error),
                Err(error) if depth == DEEPEST || tried > MOST => return Err(error),
                _ if depth == DEEPEST || tried > MOST => {
                    let place = to_f64(&(&self.middle + &self.half * low));
                    let place = if force.is_far { 1.0 / place } else { place };
                    return Err(LawNotProved::Open(decimal(place)));
                }
                _ => {
                    let middle = (&low + &high) / &two;
                    open.push((middle.clone(), high, depth + 1));
                    open.push((low, middle, depth + 1));
                }
            }
        }
        Ok(largest)
    }

    /// An upper bound of the error between two values of e, by the mean value form or from the values on
    /// the whole interval.
    fn error_between(
        &self,
        force: &ForceOnRange,
        certificate: &LawCertificate,
        [low, high]: [&Rational; 2],
    ) -> Result<f64, LawNotProved> {
        let place = |e: &Rational| &self.middle + &self.half * e;
        let middle = (low + high) / Integer::from(2);
        let of = |mut variable: Variable, e: &Ball| {
            let truth = self.truth.at(e, &self.half);
            // The restitution is some number within the remainder of its polynomial.
            variable.restitution = self.restitution.as_ref().map(|own| {
                let polynomial = own.at(e, &self.half);
                Jet { value: widened(&polynomial.value, own.remainder), ..polynomial }
            });
            quotient(certificate, force, &truth, &variable)
        };
        let no_value = || LawNotProved::NoValue(certificate.law.to_string());
        let spread = Bound::of_fraction(&((high - low) / Integer::from(2)));
        let e = WORKING.fraction(&middle);
        let whole = Variable::between(&place(low), &place(high));
        let whole = of(whole, &widened(&e, spread))?.ok_or_else(no_value)?;
        let there = of(Variable::at(&place(&middle)), &e)?.ok_or_else(no_value)?;
        let width = spread * Bound::of_fraction(&self.half);
        let by_slope = widened(&there.value, width * WORKING.magnitude(&whole.slope));
        let quotient = match by_slope.radius <= whole.value.radius {
            true => by_slope,
            false => whole.value,
        };
        // The polynomial stands for the truth up to a relative error of the remainder.
        let around = self.truth.at(&widened(&e, spread), &self.half).value;
        let apart = self.truth.remainder.over(WORKING.distance_from_zero(&around));
        let factor = Jet::constant(widened(&WORKING.integer(1), apart));
        let power = Rational::from_integer(certificate.quantity.power().into());
        let factor = factor.to_power(&power).ok_or_else(no_value)?.value;
        let quotient = WORKING.product(&quotient, &factor);
        Ok(WORKING.magnitude(&WORKING.difference(&quotient, &WORKING.integer(1))).value())
    }
}

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
mod cosine_series;
mod inverse_frequency;
mod jet;
mod mode;

use std::sync::OnceLock;

use num_traits::{One as _, Signed as _, Zero as _};

use super::double_series::{DoubleSeries, nearest};
use super::elementary::Analytic;
use super::force::NoValue;
use super::fourier_series::{FourierSeries, WORKING};
use super::{CheckError, NotCertified, coordinate};
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
use cosine_series::CosineSeries;
use inverse_frequency::{ForceOnRange, PiecePolynomial, Scale, TruthPiece};
use jet::{Jet, LawValues, Scaled, Variable, law_along, widened};
pub use mode::ModeBranch;

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

/// The motions that a law is about, one for each value of its variable.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionsOfLaw {
    /// Motions of one coordinate.
    Coordinate {
        /// `f` of `x'' + f = 0`, in the symbol [`x`](coordinate) and the variable; of a contact
        /// `x^n (1 + c x')`, with numbers.
        force: Expr,
        /// The mass M of `M x'' + (dM/dx) x'^2/2 + f = 0` where it depends on the position.
        mass: Option<Expr>,
        /// The start of the motion.
        start: StartOfLaw,
    },
    /// A nonlinear normal mode, whose amplitude is the variable.
    Mode(ModeBranch),
}

/// A law on a range, and what is claimed of its error. The numbers may be anything: [`check_law`]
/// trusts none of them.
#[derive(Clone, Debug, PartialEq)]
pub struct LawCertificate {
    /// The motions.
    pub motions: MotionsOfLaw,
    /// The amplitude or the parameter on which the law depends; of a contact the speed at the touch.
    pub variable: Symbol,
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
    /// No branch of the mode is proved to go through this amplitude.
    #[error("no single motion of the mode is proved at the amplitude {0}")]
    NoMode(String),
    /// The motion at the lower end of the range is not that which names the branch.
    #[error("the motion at the lower end of the range is not that of the branch")]
    AnotherMode,
    /// A force that is no polynomial, on a range that begins at rest.
    #[error(
        "a proof of a mode from rest is of polynomial forces, not of {0}: begin the range above zero"
    )]
    FromRest(String),
    /// The approximate motions of the mode are not found.
    #[error("the motion of the mode at the lower end of the range is not found: {0}")]
    NoBranch(Box<NotCertified>),
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
/// use lindstedt::certificate::{LawCertificate, LawQuantity, MotionsOfLaw, StartOfLaw, check_law};
/// use lindstedt::exact::ratio;
///
/// let mut law = LawCertificate {
///     motions: MotionsOfLaw::Coordinate {
///         force: "sin(x)".parse()?,
///         mass: None,
///         start: StartOfLaw::Variable,
///     },
///     variable: "A".into(),
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
    /// Checks that letters and ends belong together; the error names what does not.
    fn well_formed(&self) -> Result<(), &'static str> {
        let ends = match &self.to {
            Some(to) => self.from < *to && self.worst <= *to,
            None => true,
        };
        let is_contact = self.quantity == LawQuantity::ContactTime;
        let of_law = if is_contact { restitution() } else { self.variable };
        if !ends || self.from.is_negative() || self.worst < self.from {
            return Err("an empty range, or a worst place outside of it");
        }
        match &self.motions {
            MotionsOfLaw::Coordinate { force, mass, start } => {
                self.well_formed_coordinate(force, mass.as_ref(), start)
            }
            MotionsOfLaw::Mode(_) if is_contact => Err("a contact of several coordinates"),
            MotionsOfLaw::Mode(_) if self.to.is_none() => Err("an amplitude that goes to infinity"),
            MotionsOfLaw::Mode(branch) => branch.well_formed(self.variable),
        }?;
        match is_known(&self.law, &[self.variable, of_law]) {
            true => Ok(()),
            false => Err("a law with letters that have no value"),
        }
    }

    /// Checks the same of a motion of one coordinate.
    fn well_formed_coordinate(
        &self,
        force: &Expr,
        mass: Option<&Expr>,
        start: &StartOfLaw,
    ) -> Result<(), &'static str> {
        let is_moving = mass.is_some_and(|mass| mass.contains(self.variable));
        let is_contact = self.quantity == LawQuantity::ContactTime;
        let of_force = if is_contact { coordinate().derivative() } else { self.variable };
        let start_fits = match start {
            StartOfLaw::Variable => self.to.is_some() && !force.contains(self.variable),
            StartOfLaw::Fixed(start) => start.is_positive() && !is_contact,
        };
        let demands = [
            (self.variable != coordinate(), "a variable that is the coordinate"),
            (
                !is_contact || self.variable != restitution(),
                "a variable with the letter of the restitution",
            ),
            (
                is_known(force, &[coordinate(), self.variable, of_force]),
                "a force with letters that have no value",
            ),
            (
                mass.is_none_or(|mass| {
                    is_known(mass, &[coordinate(), self.variable]) && !is_contact
                }),
                "a mass with letters that have no value, or a contact with one",
            ),
            (
                !is_moving || *start != StartOfLaw::Variable && self.to.is_some(),
                "a mass that depends on the amplitude, or on a parameter that goes to infinity",
            ),
            (
                start_fits,
                "a start that is not positive, or an amplitude that goes to infinity or is a parameter",
            ),
        ];
        match demands.into_iter().find(|(holds, _)| !holds) {
            Some((_, reason)) => Err(reason),
            None => Ok(()),
        }
    }
}

/// Whether an expression has no other letters than these.
fn is_known(expression: &Expr, letters: &[Symbol]) -> bool {
    expression.symbols().iter().all(|name| letters.contains(name))
}

/// The true frequency on a whole range, enclosed.
pub struct TrueFrequency {
    /// The force of a motion of one coordinate.
    force: Option<ForceOnRange>,
    /// In the variable, and in r = 1/p.
    near_pieces: Vec<TruthPiece>,
    far_pieces: Vec<TruthPiece>,
    /// Whether the pieces are of doubles, and then those of balls, once a law asks for them.
    is_of_doubles: bool,
    of_balls: OnceLock<Option<Box<Self>>>,
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
        certificate.well_formed().map_err(LawNotProved::Malformed)?;
        if let MotionsOfLaw::Mode(branch) = &certificate.motions {
            let infinite = || LawNotProved::Malformed("an amplitude that goes to infinity");
            let (from, to) = (&certificate.from, certificate.to.as_ref().ok_or_else(infinite)?);
            let near_pieces = branch.pieces(certificate.variable, from, to, supervision)?;
            return Ok(Self::of_pieces(None, [near_pieces, vec![]]));
        }
        match Self::enclosed::<DoubleSeries>(certificate, supervision) {
            Ok(truth) => Ok(Self { is_of_doubles: true, ..truth }),
            // The digits of doubles may be too few.
            Err(LawNotProved::NoValue(_)) => {
                Self::enclosed::<FourierSeries>(certificate, supervision)
            }
            Err(error) => Err(error),
        }
    }

    /// The truth on these pieces, in the variable and in r.
    fn of_pieces(
        force: Option<ForceOnRange>,
        [near_pieces, far_pieces]: [Vec<TruthPiece>; 2],
    ) -> Self {
        Self { force, near_pieces, far_pieces, is_of_doubles: false, of_balls: OnceLock::new() }
    }

    /// The truth of one coordinate over these series.
    fn enclosed<S: CosineSeries>(
        certificate: &LawCertificate,
        supervision: Supervision,
    ) -> Result<Self, LawNotProved> {
        match &certificate.motions {
            MotionsOfLaw::Coordinate { force, .. }
                if certificate.quantity == LawQuantity::ContactTime =>
            {
                Self::of_contact::<S>(certificate, force, supervision)
            }
            MotionsOfLaw::Coordinate { force, mass, start } => {
                Self::of_coordinate::<S>(certificate, force, mass.as_ref(), start, supervision)
            }
            MotionsOfLaw::Mode(_) => Err(LawNotProved::Malformed("a mode of one coordinate")),
        }
    }

    /// Returns this truth enclosed over balls; `None` if that has no value.
    fn of_balls(&self, certificate: &LawCertificate, supervision: Supervision) -> Option<&Self> {
        let enclosed = || Self::enclosed::<FourierSeries>(certificate, supervision).ok();
        match self.is_of_doubles {
            true => self.of_balls.get_or_init(|| enclosed().map(Box::new)).as_deref(),
            false => Some(self),
        }
    }

    /// The frequency of a motion of one coordinate.
    fn of_coordinate<S: CosineSeries>(
        certificate: &LawCertificate,
        force: &Expr,
        mass: Option<&Expr>,
        start: &StartOfLaw,
        supervision: Supervision,
    ) -> Result<Self, LawNotProved> {
        let variable = certificate.variable;
        let at_zero = force.substitute(coordinate(), &Expr::zero())?.expand()?;
        if !at_zero.is_zero() {
            return Err(LawNotProved::NotCentred(force.to_string()));
        }
        let near = ForceOnRange::new(start, variable, force.clone(), Scale::OWN)?.with_mass(mass);
        let (from, one) = (&certificate.from, Rational::one());
        let (near_pieces, far_pieces) = match &certificate.to {
            Some(to) => (near.pieces::<S>(from, to, supervision)?, vec![]),
            None => {
                let far = Self::far(variable, force, start)?.with_mass(mass);
                let pieces =
                    far.pieces::<S>(&Rational::zero(), &from.max(&one).recip(), supervision)?;
                let near_pieces = match *from < one {
                    true => near.pieces::<S>(from, &one, supervision)?,
                    false => vec![],
                };
                (near_pieces, pieces)
            }
        };
        Ok(Self::of_pieces(Some(near), [near_pieces, far_pieces]))
    }

    /// T/T_0 and the restitution of the contact of a certificate.
    fn of_contact<S: CosineSeries>(
        certificate: &LawCertificate,
        force: &Expr,
        supervision: Supervision,
    ) -> Result<Self, LawNotProved> {
        let no_contact = || LawNotProved::NoContact(force.to_string());
        let contact = HuntCrossleyForce::of(force, coordinate())?;
        let contact = contact.ok_or_else(no_contact)?;
        let damping = contact.damping.as_number().ok_or_else(no_contact)?;
        let mean = ContactMean::new(&contact.exponent, damping).ok_or_else(no_contact)?;
        let near = ForceOnRange::of_contact(mean, certificate.variable)?;
        let to = certificate.to.as_ref().ok_or_else(no_contact)?;
        let near_pieces = near.pieces::<S>(&certificate.from, to, supervision)?;
        Ok(Self::of_pieces(Some(near), [near_pieces, vec![]]))
    }

    /// `1/omega` at a place of a bounded range, or T/T_0 and the restitution, to the digits of a double.
    pub fn at(&self, place: f64) -> Option<[f64; 2]> {
        let exact = from_f64(place)?;
        let piece = self.piece_at(&exact)?;
        let e = WORKING.fraction(&((&exact - &piece.middle) / &piece.half));
        let value = |own: &PiecePolynomial| nearest(&own.value(&e));
        let restitution = piece.restitution.as_ref().map_or(f64::NAN, value);
        Some([value(&piece.truth), restitution])
    }

    /// The piece of a bounded range that a place lies in.
    fn piece_at(&self, place: &Rational) -> Option<&TruthPiece> {
        let ends_after = |piece: &&TruthPiece| *place <= &piece.middle + &piece.half;
        self.near_pieces.iter().find(ends_after).or(self.near_pieces.last())
    }

    /// The force in `r = 1/p`, times the power of r with which it has a value at zero.
    fn far(name: Symbol, force: &Expr, start: &StartOfLaw) -> Result<ForceOnRange, LawNotProved> {
        let variable = Expr::from(name);
        let inverse = Expr::divide(&Expr::one(), &variable)?;
        let force = force.substitute(name, &inverse)?;
        for power in 0..=MOST_GROWTH {
            let scaled = (&variable.integer_power(i64::from(power))? * &force).expand()?;
            if scaled.substitute(name, &Expr::zero()).is_ok_and(|limit| !limit.is_zero()) {
                return ForceOnRange::new(start, name, scaled, Scale { power, is_far: true });
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
        let by_doubles = self.largest_error_over::<DoubleSeries>(certificate, supervision);
        match by_doubles {
            Ok(error) => Ok(error),
            Err(error @ (LawNotProved::Stopped | LawNotProved::Growth(_))) => Err(error),
            Err(error) => match self.of_balls(certificate, supervision) {
                Some(truth) => truth.largest_error_over::<FourierSeries>(certificate, supervision),
                None => Err(error),
            },
        }
    }

    fn largest_error_over<S: CosineSeries>(
        &self,
        certificate: &LawCertificate,
        supervision: Supervision,
    ) -> Result<f64, LawNotProved> {
        let bound = not_above(&certificate.claim[1]);
        let mut largest = 0.0_f64;
        for piece in self.near_pieces.iter().chain(&self.far_pieces) {
            largest = largest.max(piece.largest_error::<S>(certificate, bound, supervision)?);
        }
        Ok(largest)
    }

    /// A lower bound of the error of the law of a certificate at its worst place.
    ///
    /// # Errors
    /// No value there.
    pub fn least_error(&self, certificate: &LawCertificate) -> Result<f64, LawNotProved> {
        /// The part of the error that may be unknown after a calculation in doubles.
        const UNKNOWN: f64 = 1e-8;
        let [least, most] = match self.error_at_worst_place::<DoubleSeries>(certificate) {
            Ok(error) => error,
            Err(LawNotProved::NoValue(_)) => [0.0, f64::INFINITY],
            Err(error) => return Err(error),
        };
        match most - least <= UNKNOWN * least {
            true => Ok(least),
            false => Ok(self.error_at_worst_place::<FourierSeries>(certificate)?[0]),
        }
    }

    /// Bounds of the error of a law at its worst place.
    fn error_at_worst_place<S: CosineSeries>(
        &self,
        certificate: &LawCertificate,
    ) -> Result<[f64; 2], LawNotProved> {
        let no_value = || LawNotProved::NoValue(certificate.law.to_string());
        let place = WORKING.fraction(&certificate.worst);
        let truth = match (&self.force, &certificate.motions) {
            (Some(force), MotionsOfLaw::Coordinate { start: StartOfLaw::Variable, .. })
                if place.is_zero() =>
            {
                force.at_rest::<S>()?
            }
            (Some(force), _) => {
                let near = self.piece_at(&certificate.worst).and_then(|piece| piece.turns);
                force.truth::<S>(&place, near)?
            }
            (None, _) => {
                let piece = self.piece_at(&certificate.worst).ok_or_else(no_value)?;
                let e = WORKING.fraction(&((&certificate.worst - &piece.middle) / &piece.half));
                vec![piece.truth.within(&e, &piece.half).value]
            }
        };
        let mut truth = truth.into_iter().map(Jet::constant);
        let mut variable = Variable::at(&certificate.worst);
        let (truth, e) = (truth.next().ok_or_else(no_value)?, truth.next());
        variable.restitution = e;
        let quotient =
            quotient(certificate, Scale::OWN, &truth, &variable)?.ok_or_else(no_value)?;
        let error = WORKING.difference(&quotient.value, &WORKING.integer(1));
        let least = WORKING.distance_from_zero(&error).max(0.0);
        Ok([least, WORKING.magnitude(&error).value()])
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
fn quotient<V: LawValues>(
    certificate: &LawCertificate,
    scale: Scale,
    inverse_frequency: &V,
    variable: &Variable<V>,
) -> Result<Option<V>, LawNotProved> {
    let law = law_along(&certificate.law, certificate.variable, variable, scale.is_far)?;
    let power = certificate.quantity.power();
    // q = law (1/omega)^n, with (1/omega) = r^(d/2) I.
    let exponent = Rational::new((i64::from(scale.power) * i64::from(power)).into(), 2.into());
    let whole = Rational::from_integer(power.into());
    let Some(truth) = inverse_frequency.to_power(&whole) else { return Ok(None) };
    let scaled = Scaled { power: &law.power + exponent, values: law.values.times(&truth) };
    match scaled.power.is_negative() && !variable.from.is_positive() {
        true => Err(LawNotProved::Growth(certificate.variable)),
        false => Ok(scaled.unscaled(variable)),
    }
}

/// The truth on a part of a piece, as series of Chebyshev.
struct PieceInterval<S> {
    /// The ends, between -1 and 1.
    ends: [Rational; 2],
    truth: S,
    /// The restitution of a contact.
    restitution: Option<S>,
    /// The number of times that the piece was halved.
    halvings: u32,
}

impl<S: CosineSeries> PieceInterval<S> {
    /// The upper or the lower half.
    fn half(&self, is_upper: bool) -> Self {
        let [low, high] = &self.ends;
        let middle = (low + high) / Integer::from(2);
        Self {
            ends: if is_upper { [middle, high.clone()] } else { [low.clone(), middle] },
            truth: self.truth.on_half(is_upper),
            restitution: self.restitution.as_ref().map(|own| own.on_half(is_upper)),
            halvings: self.halvings + 1,
        }
    }
}

impl TruthPiece {
    /// An upper bound of the error of a law on this piece, which is halved until that is within a
    /// bound.
    fn largest_error<S: CosineSeries>(
        &self,
        certificate: &LawCertificate,
        bound: f64,
        supervision: Supervision,
    ) -> Result<f64, LawNotProved> {
        /// The most halvings of a piece, and the most parts of it.
        const DEEPEST: u32 = 40;
        const MOST: usize = 200_000;
        let whole = PieceInterval {
            ends: [-Rational::one(), Rational::one()],
            truth: self.truth.series::<S>(),
            restitution: self.restitution.as_ref().map(PiecePolynomial::series::<S>),
            halvings: 0,
        };
        let mut open = vec![whole];
        let (mut largest, mut tried) = (0.0_f64, 0);
        while let Some(interval) = open.pop() {
            tried += 1;
            if tried % 256 == 0 && supervision.interrupt.is_requested() {
                return Err(LawNotProved::Stopped);
            }
            let by_series = self.error_along(certificate, &interval);
            let error = match by_series {
                // A law without a series, as a root of the variable from zero on, has values.
                Err(LawNotProved::NoValue(_)) => {
                    self.error_between(certificate, interval.ends.each_ref())
                }
                by_series => by_series,
            };
            let is_last = interval.halvings == DEEPEST || tried > MOST;
            match error {
                Ok(error) if error <= bound => largest = largest.max(error),
                Err(error @ LawNotProved::Growth(_)) => return Err(error),
                Err(error) if is_last => return Err(error),
                _ if is_last => {
                    let place = to_f64(&(&self.middle + &self.half * &interval.ends[0]));
                    let place = if self.scale.is_far { 1.0 / place } else { place };
                    return Err(LawNotProved::Open(decimal(place)));
                }
                _ => open.extend([true, false].map(|is_upper| interval.half(is_upper))),
            }
        }
        Ok(largest)
    }

    /// An upper bound of the error on an interval, from the series of Chebyshev of `law/truth`.
    fn error_along<S: CosineSeries>(
        &self,
        certificate: &LawCertificate,
        interval: &PieceInterval<S>,
    ) -> Result<f64, LawNotProved> {
        let no_value = || LawNotProved::NoValue(certificate.law.to_string());
        let [from, to] = interval.ends.each_ref().map(|e| &self.middle + &self.half * e);
        let mut variable = Variable::along(&from, &to);
        variable.restitution = interval.restitution.clone();
        let quotient = quotient(certificate, self.scale, &interval.truth, &variable)?;
        let quotient = quotient.ok_or_else(no_value)?;
        Ok(quotient.difference(&<S as Analytic>::integer(1)).largest_value().value())
    }

    /// An upper bound of the error between two values of e, by the mean value form or from the values on
    /// the whole interval.
    fn error_between(
        &self,
        certificate: &LawCertificate,
        [low, high]: [&Rational; 2],
    ) -> Result<f64, LawNotProved> {
        let place = |e: &Rational| &self.middle + &self.half * e;
        let middle = (low + high) / Integer::from(2);
        let of = |mut variable: Variable<Jet>, e: &Ball| {
            let truth = self.truth.at(e, &self.half);
            // The restitution is some number within the remainder of its polynomial.
            variable.restitution = self.restitution.as_ref().map(|own| own.within(e, &self.half));
            quotient(certificate, self.scale, &truth, &variable)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::ratio;

    /// `sqrt(A)` has no series of Chebyshev from zero on. The error of the law at 1/2 was computed from the
    /// elliptic integral with 20 digits: `(1 - A^2/16 - sqrt(A)/100) 2 K(sin(A/2))/pi - 1`.
    #[test]
    fn a_law_with_a_root_from_zero_on_is_bounded_by_its_values() {
        const ERROR: f64 = 0.007_203_326_831_296_678;
        let law = |upper: Rational| LawCertificate {
            motions: MotionsOfLaw::Coordinate {
                force: "sin(x)".parse().unwrap(),
                mass: None,
                start: StartOfLaw::Variable,
            },
            variable: "A".into(),
            quantity: LawQuantity::Frequency,
            law: "1 - A^2/16 - sqrt(A)/100".parse().unwrap(),
            from: ratio(0, 1),
            to: Some(ratio(1, 2)),
            worst: ratio(1, 2),
            claim: [ratio(72_033, 10_000_000), upper],
        };
        let error = check_law(&law(ratio(72_040, 10_000_000))).unwrap();
        assert!(error.lower <= ERROR && ERROR <= error.upper, "{error:?}");
        assert!(error.lower > ERROR - 1e-12 && error.upper < 7.2041e-3, "{error:?}");
        assert!(check_law(&law(ratio(72_033, 10_000_000))).is_err());
    }
}

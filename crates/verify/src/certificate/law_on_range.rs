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
//! [`FourierSeries`]. On each of some pieces of the range `1/omega` is a polynomial through sixteen of
//! its values, with a remainder from a bound on a disc of complex values of the variable about the
//! piece. On an interval `|v - m| <= h` the quotient `q = law/truth` is within `h max |q'|` of its value
//! in the middle, and intervals are halved until that is within the claim; a range to infinity ends with
//! pieces of `r = 1/p`, in which the powers of r are kept apart.
//!
//! In: a force, a law, a range and a claim. Out: bounds of the largest `|q - 1|`. A piece costs some
//! seventeen series of `G^(-1/2)`, an interval the law and a polynomial of degree 15; there are the more
//! intervals the smaller the error is, as its root.
//!
//! Sources: L. D. Landau, E. M. Lifshitz, Mechanics, section 11, for the quarter period; L. N. Trefethen,
//! Approximation Theory and Approximation Practice, SIAM 2013, chapter 11, for the remainder (Hermite's
//! integral); R. E. Moore, Interval Analysis, Prentice-Hall 1966, chapter 6, for the mean value form.

use std::collections::BTreeMap;

use num_traits::{One as _, Signed as _, ToPrimitive as _, Zero as _};

use super::force::{NoValue, along_all, function_of, is_odd};
use super::fourier_series::{FourierSeries, WORKING};
use super::{CheckError, coordinate};
use crate::conservative::CentredForce;
use crate::decimal::decimal;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::rational::{from_f64, to_f64};
use crate::exact::{Integer, Rational};
use crate::expr::{Expr, ExprError, Function, Node};
use crate::interrupt::Supervision;
use crate::symbol::Symbol;

/// The quantity that a law gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawQuantity {
    /// The angular frequency.
    Frequency,
    /// Its square.
    FrequencySquared,
    /// The period over 2 pi.
    Period,
}

impl LawQuantity {
    /// The power of omega that the quantity is.
    pub const fn power(self) -> i32 {
        match self {
            Self::Frequency => 1,
            Self::FrequencySquared => 2,
            Self::Period => -1,
        }
    }

    /// Its name: `omega`, `omega^2` or `T/(2*pi)`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Frequency => "omega",
            Self::FrequencySquared => "omega^2",
            Self::Period => "T/(2*pi)",
        }
    }
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
    /// `f` of `x'' + f = 0`, in the symbol [`x`](coordinate) and the variable.
    pub force: Expr,
    /// The amplitude or the parameter on which the law depends.
    pub variable: Symbol,
    /// The start of the motion.
    pub start: StartOfLaw,
    /// The quantity.
    pub quantity: LawQuantity,
    /// The law as an expression in the variable.
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
        "a proof on a range is of motions about an equilibrium at zero, and `{0}` is not zero there"
    )]
    NotCentred(String),
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
        let depends_on_variable = self.force.contains(self.variable);
        let start = match &self.start {
            StartOfLaw::Variable => self.to.is_some() && !depends_on_variable,
            StartOfLaw::Fixed(start) => start.is_positive(),
        };
        let demands = [
            (
                ends && !self.from.is_negative() && self.worst >= self.from,
                "an empty range, or a worst place outside of it",
            ),
            (self.variable != coordinate(), "a variable that is the coordinate"),
            (
                is_known(&self.force, &[coordinate(), self.variable]),
                "a force with letters that have no value",
            ),
            (is_known(&self.law, &[self.variable]), "a law with letters that have no value"),
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

/// The force of a law and its derivatives, in one variable.
struct ForceOnRange {
    /// The start of the motion.
    start: StartOfLaw,
    /// The variable.
    variable: Symbol,
    /// The force, in the variable or its reciprocal r.
    force: Expr,
    /// Its derivative by the position.
    by_place: Expr,
    /// Whether it is odd.
    is_odd: bool,
    /// Its derivative by the variable along the motion, in x, the derivative of x and the variable.
    slope: Expr,
    /// The derivative of that along an odd motion, whose places change in proportion to the variable.
    curvature: Expr,
    /// The second derivative by the position.
    bend: Expr,
    /// The power d of r with which `r^d f` has a value at r = 0; zero in the variable itself.
    power: u32,
    /// Whether the variable is r.
    is_far: bool,
}

/// `1/omega` on a part of the range, as a polynomial in `e = (v - middle)/half`.
struct TruthPiece {
    middle: Rational,
    half: Rational,
    /// Its coefficients, the constant first.
    coefficients: Vec<Ball>,
    /// Bound of the distance of `1/omega` from the polynomial.
    remainder: Bound,
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

/// Number of places at which `1/omega` is computed on a piece, and the ratio of the radius of the disc
/// on which it is bounded to half of its width.
const NODES: usize = 16;
const WIDER: u32 = 4;

/// The least part of the range that a piece may be, as a power of two.
const THINNEST: u32 = 14;

/// The symbol that stands for the derivative of a place of the motion by the variable.
fn moving() -> Symbol {
    coordinate().derivative()
}

/// The motion `x = m + r cos(theta)`.
struct Extent {
    middle: Ball,
    radius: Ball,
}

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
        let at_zero = force.substitute(coordinate(), &Expr::zero())?.expand()?;
        if !at_zero.is_zero() {
            return Err(LawNotProved::NotCentred(force.to_string()));
        }
        let near = ForceOnRange::new(start, *variable, force.clone(), 0, false)?;
        let (from, one) = (&certificate.from, Rational::one());
        let (near_pieces, far, far_pieces) = match &certificate.to {
            Some(to) => (near.pieces(from, to, supervision)?, None, vec![]),
            None => {
                let far = Self::far(certificate)?;
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
            false => self.near.inverse_frequency(&place)?,
        };
        let truth = Jet::constant(truth);
        let variable = Variable::at(&certificate.worst);
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
        let of = |variable: &Variable, e: &Ball| {
            let truth = self.inverse_frequency(e);
            quotient(certificate, force, &truth, variable)
        };
        let no_value = || LawNotProved::NoValue(certificate.law.to_string());
        let spread = Bound::of_fraction(&((high - low) / Integer::from(2)));
        let e = WORKING.fraction(&middle);
        let whole = Variable::between(&place(low), &place(high));
        let whole = of(&whole, &widened(&e, spread))?.ok_or_else(no_value)?;
        let there = of(&Variable::at(&place(&middle)), &e)?.ok_or_else(no_value)?;
        let width = spread * Bound::of_fraction(&self.half);
        let by_slope = widened(&there.value, width * WORKING.magnitude(&whole.slope));
        let quotient = match by_slope.radius <= whole.value.radius {
            true => by_slope,
            false => whole.value,
        };
        // The polynomial stands for the truth up to a relative error of the remainder.
        let least = WORKING.distance_from_zero(&self.inverse_frequency(&widened(&e, spread)).value);
        let apart = self.remainder.over(least);
        let factor = Jet::constant(widened(&WORKING.integer(1), apart));
        let power = Rational::from_integer(certificate.quantity.power().into());
        let factor = factor.to_power(&power).ok_or_else(no_value)?.value;
        let quotient = WORKING.product(&quotient, &factor);
        Ok(WORKING.magnitude(&WORKING.difference(&quotient, &WORKING.integer(1))).value())
    }

    /// The polynomial and its derivative by the variable.
    fn inverse_frequency(&self, e: &Ball) -> Jet {
        let (mut value, mut slope) = (Ball::zero(), Ball::zero());
        for coefficient in self.coefficients.iter().rev() {
            slope = WORKING.sum(&WORKING.product(&slope, e), &value);
            value = WORKING.sum(&WORKING.product(&value, e), coefficient);
        }
        let slope = WORKING.quotient(&slope, &WORKING.fraction(&self.half));
        let slope = slope.unwrap_or(Ball { middle: Integer::zero(), radius: Bound::UNKNOWN });
        Jet { value, slope }
    }
}

impl ForceOnRange {
    fn new(
        start: &StartOfLaw,
        variable: Symbol,
        force: Expr,
        power: u32,
        is_far: bool,
    ) -> Result<Self, LawNotProved> {
        let by_place = force.differentiate(coordinate())?;
        let bend = by_place.differentiate(coordinate())?;
        let along = Expr::from(moving());
        let slope = &by_place * &along + force.differentiate(variable)?;
        let curvature = &bend * &along.integer_power(2)?
            + Expr::from(2) * &along * by_place.differentiate(variable)?
            + force.differentiate(variable)?.differentiate(variable)?;
        let is_odd = is_odd(&force, &[coordinate()])?;
        let start = start.clone();
        Ok(Self { start, variable, force, by_place, is_odd, slope, curvature, bend, power, is_far })
    }

    /// The pieces of a range, each as wide as a bound on a disc about it allows.
    fn pieces(
        &self,
        from: &Rational,
        to: &Rational,
        supervision: Supervision,
    ) -> Result<Vec<TruthPiece>, LawNotProved> {
        let steps = 1_u32 << THINNEST;
        let place =
            |position: u32| from + (to - from) * Rational::new(position.into(), steps.into());
        let (mut position, mut width) = (0, steps / 4);
        let mut pieces = vec![];
        while position < steps {
            if supervision.interrupt.is_requested() {
                return Err(LawNotProved::Stopped);
            }
            let next = (position + width).min(steps);
            match self.piece(&place(position), &place(next)) {
                Ok(piece) => {
                    pieces.push(piece);
                    (position, width) = (next, 2 * width);
                }
                Err(error @ LawNotProved::NoValue(_)) if width == 1 => return Err(error),
                Err(LawNotProved::NoValue(_)) => width = (width / 2).min(next - position),
                Err(error) => return Err(error),
            }
        }
        Ok(pieces)
    }

    /// `1/omega` between two places: the polynomial through its values at points like those of
    /// Chebyshev. With `|1/omega| <= M` on the disc of radius rho about the middle and `|v - middle| <=
    /// h`, it is off by at most `M rho/(rho - h) max |w(v)|/(rho - h)^n`, w the product of the distances
    /// from the points.
    fn piece(&self, from: &Rational, to: &Rational) -> Result<TruthPiece, LawNotProved> {
        let two = Integer::from(2);
        let (middle, half) = ((from + to) / &two, (to - from) / &two);
        let radius = &half * Integer::from(WIDER);
        let begins_at_rest = self.start == StartOfLaw::Variable && from.is_zero();
        let largest = match begins_at_rest {
            true => self.bound_about_rest(&(&radius + &middle))?,
            false => self.bound_on_disc(&middle, &radius)?,
        };
        let nodes = nodes();
        let values = nodes
            .iter()
            .map(|node| self.inverse_frequency(&WORKING.fraction(&(&middle + &half * node))));
        let values = values.collect::<Result<Vec<Ball>, _>>()?;
        // |w| on [-1, 1] in units of h, and the distance of the circle from the points in the same.
        let outside = f64::from(WIDER - 1);
        let apart = (0..NODES).fold(largest_product(&nodes), |bound, _| bound.over(outside));
        let remainder = largest * Bound::exactly(f64::from(WIDER)).over(outside) * apart;
        Ok(TruthPiece { middle, half, coefficients: interpolated(&nodes, values), remainder })
    }

    /// x(0) with the variable in a ball, and its derivative by the variable.
    fn start(&self, variable: &Ball) -> [Ball; 2] {
        match &self.start {
            StartOfLaw::Variable => [variable.clone(), WORKING.integer(1)],
            StartOfLaw::Fixed(start) => [WORKING.fraction(start), Ball::zero()],
        }
    }

    /// An expression along a motion with the variable in a ball; the second extent is the derivative
    /// of the first by the variable.
    fn along(
        &self,
        expression: &Expr,
        variable: &Ball,
        [extent, change]: [&Extent; 2],
    ) -> Result<FourierSeries, LawNotProved> {
        let series = |extent: &Extent| {
            let cosines = vec![extent.middle.clone(), extent.radius.clone()];
            FourierSeries::exactly(cosines, vec![]).of_digits(DIGITS)
        };
        let (motion, change) = (series(extent), series(change));
        let variable = FourierSeries::constant(variable.clone());
        let letters = [(coordinate(), &motion), (moving(), &change), (self.variable, &variable)];
        Ok(along_all(expression, &letters)?)
    }

    /// An expression at a place of the coordinate.
    fn at(&self, expression: &Expr, variable: &Ball, place: &Ball) -> Result<Ball, LawNotProved> {
        let there = Extent { middle: place.clone(), radius: Ball::zero() };
        let nothing = Extent::of_odd(Ball::zero());
        Ok(self.along(expression, variable, [&there, &nothing])?.at_zero())
    }

    /// The stiffness at rest, a constant.
    fn stiffness(&self, variable: &Ball) -> Result<FourierSeries, LawNotProved> {
        Ok(FourierSeries::constant(self.at(&self.by_place, variable, &Ball::zero())?))
    }

    /// The motion at a value of the variable.
    fn extent(&self, place: &Ball) -> Result<Extent, LawNotProved> {
        let [start, _] = self.start(place);
        match self.is_odd {
            true => Ok(Extent::of_odd(start)),
            false => {
                let end = self.turning_point(place, &start)?;
                Ok(Extent::between(&start, &end))
            }
        }
    }

    /// The other turning point: a number in doubles, improved by Newton's iteration on `V(a) - V(b)`,
    /// whose derivative by b is -f(b), and then the interval in which that has its zero.
    fn turning_point(&self, place: &Ball, start: &Ball) -> Result<Ball, LawNotProved> {
        const STEPS: usize = 1;
        let none = || LawNotProved::NoValue("the turning point".to_owned());
        let numbers = BTreeMap::from([(self.variable, WORKING.nearest(place))]);
        let from = WORKING.nearest(start);
        let force = CentredForce::new(&self.force, coordinate(), &Expr::zero(), &numbers, from);
        let end = force.and_then(|force| force.turning_point(from).ok()).and_then(from_f64);
        let mut end = WORKING.fraction(&end.ok_or_else(none)?);
        let nothing = Extent::of_odd(Ball::zero());
        let mut work = Ball::zero();
        for step in 0..=STEPS {
            let extent = Extent::between(start, &end);
            let series = self.along(&self.force, place, [&extent, &nothing])?;
            work = WORKING.product(&work_between(&series), &WORKING.scaled(&extent.radius, 2));
            if step < STEPS {
                let force = self.at(&self.force, place, &end)?;
                let more = WORKING.quotient(&work, &force).ok_or_else(none)?;
                end = widened(&WORKING.sum(&end, &more), Bound::ZERO);
                end.radius = Bound::ZERO;
            }
        }
        let force = WORKING.distance_from_zero(&self.at(&self.force, place, &end)?);
        let distance = WORKING.magnitude(&work).over(force) * Bound::exactly(2.0);
        let around = widened(&end, distance);
        let least = WORKING.distance_from_zero(&self.at(&self.force, place, &around)?);
        match WORKING.magnitude(&work).over(least) < distance {
            true => Ok(around),
            false => Err(none()),
        }
    }

    /// `1/omega` at a place that is not rest.
    fn inverse_frequency(&self, place: &Ball) -> Result<Ball, LawNotProved> {
        let extent = self.extent(place)?;
        let nothing = Extent::of_odd(Ball::zero());
        let rate = mean_rate(&self.along(&self.force, place, [&extent, &nothing])?);
        let rate = rate.over(&extent.radius);
        Ok(mean(&root(&rate.ok_or_else(|| LawNotProved::NoValue("1/A".to_owned()))?)?))
    }

    /// `1/omega` in the limit of small amplitudes.
    fn at_rest(&self) -> Result<Ball, LawNotProved> {
        Ok(mean(&root(&self.stiffness(&Ball::zero())?)?))
    }

    /// A bound of `|1/omega|` for all complex values of the variable within a distance of one: by the
    /// mean value theorem, whose norms hold for complex numbers too.
    fn bound_on_disc(&self, middle: &Rational, radius: &Rational) -> Result<Bound, LawNotProved> {
        let (place, spread) = (WORKING.fraction(middle), Bound::of_fraction(radius));
        let all = widened(&place, spread);
        let rate = match (self.is_odd, &self.start) {
            (false, _) => self.rate_on_disc(&place, &all, spread)?,
            (true, StartOfLaw::Fixed(_)) => self.rate_by_parameter(&place, &all, spread)?,
            (true, StartOfLaw::Variable) => self.rate_by_amplitude(&place, &all, spread)?,
        };
        Ok(root(&rate)?.norm())
    }

    /// G on a disc of a parameter, of an odd force whose motion has one amplitude.
    fn rate_by_parameter(
        &self,
        place: &Ball,
        all: &Ball,
        spread: Bound,
    ) -> Result<FourierSeries, LawNotProved> {
        let (extent, nothing) = (self.extent(place)?, Extent::of_odd(Ball::zero()));
        let at = |expression: &Expr, variable: &Ball| {
            self.along(expression, variable, [&extent, &nothing])
        };
        let over = |series: FourierSeries| {
            let rate = mean_rate(&series).over(&extent.radius);
            rate.ok_or_else(|| LawNotProved::NoValue("1/A".to_owned()))
        };
        let slope = at(&self.slope, place)?.widened(spread * at(&self.curvature, all)?.norm());
        Ok(over(at(&self.force, place)?)?.widened(spread * over(slope)?.norm()))
    }

    /// G on a disc of amplitudes, of an odd force: `G = f'(0) + L[g]/a` with `g = f - f'(0) x`, whose terms
    /// are of the size a^3.
    fn rate_by_amplitude(
        &self,
        place: &Ball,
        all: &Ball,
        spread: Bound,
    ) -> Result<FourierSeries, LawNotProved> {
        let change = Extent::of_odd(WORKING.integer(1));
        let at = |expression: &Expr, variable: &Ball| {
            let extent = Extent::of_odd(variable.clone());
            self.along(expression, variable, [&extent, &change])
        };
        let stiffness = self.stiffness(place)?;
        let subtracted = |series: FourierSeries, size: &Ball| {
            let line = FourierSeries::exactly(vec![Ball::zero(), size.clone()], vec![]);
            series.difference(&line.product(&stiffness))
        };
        let slope = at(&self.slope, place)?.widened(spread * at(&self.curvature, all)?.norm());
        let own = subtracted(at(&self.force, place)?, place);
        let slope = subtracted(slope, &WORKING.integer(1));
        let own_on_all = own.clone().widened(spread * slope.norm());
        let over = |series: &FourierSeries, by: &Ball| {
            let rate = mean_rate(series).over(by);
            rate.ok_or_else(|| LawNotProved::NoValue("1/A".to_owned()))
        };
        let rate = stiffness.sum(&over(&own, place)?);
        let square = WORKING.product(all, all);
        let by_variable = over(&slope, all)?.difference(&over(&own_on_all, &square)?);
        Ok(rate.widened(spread * by_variable.norm()))
    }

    /// G on a disc, of a force that is not odd: the other turning point b moves by
    /// `b' = (f(a) a' + int_b^a f_p dx)/f(b)`, which is bounded on a disc about it that it does not leave.
    fn rate_on_disc(
        &self,
        place: &Ball,
        all: &Ball,
        spread: Bound,
    ) -> Result<FourierSeries, LawNotProved> {
        let none = || LawNotProved::NoValue("the turning point".to_owned());
        let ([start, _], [start_on_all, change]) = (self.start(place), self.start(all));
        let end = self.turning_point(place, &start)?;
        let nothing = Extent::of_odd(Ball::zero());
        let by_variable = self.force.differentiate(self.variable)?;
        let rate_of_end = |end_on_all: &Ball| -> Result<Ball, LawNotProved> {
            let extent = Extent::between(&start_on_all, end_on_all);
            let by_variable = self.along(&by_variable, all, [&extent, &nothing])?.norm();
            let length = WORKING.magnitude(&extent.radius) * Bound::exactly(2.0);
            let force = WORKING.product(&self.at(&self.force, all, &start_on_all)?, &change);
            let work = widened(&force, length * by_variable);
            WORKING.quotient(&work, &self.at(&self.force, all, end_on_all)?).ok_or_else(none)
        };
        // A disc twice as large as the rate at its middle asks for.
        let guess = WORKING.magnitude(&rate_of_end(&end)?) * spread * Bound::exactly(2.0);
        let end_on_all = widened(&end, guess);
        let rate_of_end = rate_of_end(&end_on_all)?;
        if WORKING.magnitude(&rate_of_end) * spread > guess {
            return Err(none());
        }
        let extent = Extent::between(&start, &end);
        let on_all = Extent::between(&start_on_all, &end_on_all);
        let change = Extent::between(&change, &rate_of_end);
        let force = self.along(&self.force, place, [&extent, &nothing])?;
        let slope = self.along(&self.slope, all, [&on_all, &change])?;
        let force_on_all = force.clone().widened(spread * slope.norm());
        let over = |series: &FourierSeries, by: &Ball| mean_rate(series).over(by).ok_or_else(none);
        let square = WORKING.product(&on_all.radius, &on_all.radius);
        let turned = FourierSeries::constant(change.radius.clone());
        let by_variable = over(&slope, &on_all.radius)?
            .difference(&over(&force_on_all, &square)?.product(&turned));
        Ok(over(&force, &extent.radius)?.widened(spread * by_variable.norm()))
    }

    /// A bound of `|1/omega|` for all complex amplitudes up to a size R: `f(x) = f'(0) x + g(x)` with
    /// `|g| <= |x|^2 M/2`, M a bound of f'' on `|x| <= 2 R`.
    ///
    /// ```text
    /// f odd:  |G - f'(0)| <= R M/2
    /// else:   V = f'(0) x^2/2 (1 + e(x)),  |e| <= e_0 = 2 R M/(3 f'(0)),   b = -v u,  u^2 = (1 + e(v))/(1 + e(b)),
    ///         |u - 1| <= w = 2 e_0/(1 - e_0) <= 1,    |G - f'(0)| <= (2/3) R M (1 + w)^2/(1 - w/2)
    /// ```
    fn bound_about_rest(&self, size: &Rational) -> Result<Bound, LawNotProved> {
        let spread = Bound::of_fraction(size);
        let stiffness = self.stiffness(&Ball::zero())?;
        let nothing = Extent::of_odd(Ball::zero());
        let bend = |size: Bound| -> Result<Bound, LawNotProved> {
            let all = Extent::of_odd(widened(&Ball::zero(), size));
            Ok(self.along(&self.bend, &Ball::zero(), [&all, &nothing])?.norm())
        };
        let distance = match self.is_odd {
            true => spread * bend(spread)? / 2,
            false => {
                let bend = bend(spread * Bound::exactly(2.0))?;
                let least = WORKING.distance_from_zero(&stiffness.at_zero());
                let uneven = (spread * bend * Bound::exactly(2.0) / 3).over(least);
                let w = (uneven * Bound::exactly(2.0)).over(uneven.below_complement());
                if w.value() > 1.0 {
                    return Err(LawNotProved::NoValue("the turning point".to_owned()));
                }
                let wide = Bound::exactly(1.0) + w;
                let third = spread * bend * wide * wide * Bound::exactly(2.0) / 3;
                third.over((w / 2).below_complement())
            }
        };
        Ok(root(&stiffness.widened(distance))?.norm())
    }
}

impl Extent {
    /// The motion of an odd force with this amplitude.
    fn of_odd(amplitude: Ball) -> Self {
        Self { middle: Ball::zero(), radius: amplitude }
    }

    /// The motion between two turning points, the first one on the right.
    fn between(start: &Ball, end: &Ball) -> Self {
        Self {
            middle: WORKING.divided(&WORKING.sum(start, end), 2),
            radius: WORKING.divided(&WORKING.difference(start, end), 2),
        }
    }
}

/// `F_0 - sum_q F_2q/(4 q^2 - 1)`, the work between two turning points over twice their distance from
/// the middle.
fn work_between(force: &FourierSeries) -> Ball {
    let mut sum = force.cosine(0);
    for k in (2..force.length()).step_by(2) {
        let divisor = u32::try_from(k * k - 1).unwrap_or(u32::MAX);
        sum = WORKING.difference(&sum, &WORKING.divided(&force.cosine(k), divisor));
    }
    widened(&sum, force.tail)
}

/// `G^(-1/2)`.
fn root(rate: &FourierSeries) -> Result<FourierSeries, LawNotProved> {
    let root = rate.clone().of_digits(DIGITS).inverse_root(2);
    root.ok_or_else(|| LawNotProved::NoValue("G^(-1/2)".to_owned()))
}

/// Fractions near the points of Chebyshev between -1 and 1.
fn nodes() -> Vec<Rational> {
    let node = |i: usize| {
        let angle = std::f64::consts::PI * (i as f64 + 0.5) / NODES as f64;
        Rational::new(((angle.cos() * 65536.0).round() as i64).into(), 65536.into())
    };
    (0..NODES).map(node).collect()
}

/// A bound of `prod |e - e_j|` for e between -1 and 1: the largest value at points `1/N` apart, where
/// the distances from the next one add at most that to each factor.
fn largest_product(nodes: &[Rational]) -> Bound {
    const POINTS: i64 = 4096;
    let product = |point: i64| -> Bound {
        let place = Rational::new(point.into(), POINTS.into());
        let step = Bound::of_fraction(&Rational::new(1.into(), (2 * POINTS).into()));
        let factors = nodes.iter().map(|node| Bound::of_fraction(&(&place - node)) + step);
        factors.fold(Bound::exactly(1.0), |product, factor| product * factor)
    };
    (-POINTS..=POINTS).map(product).fold(Bound::ZERO, Bound::max)
}

/// The coefficients of the polynomial with these values at the nodes, by Newton's divided differences.
fn interpolated(nodes: &[Rational], mut values: Vec<Ball>) -> Vec<Ball> {
    let count = nodes.len();
    for order in 1..count {
        for i in (order..count).rev() {
            let over = WORKING.fraction(&(&nodes[i] - &nodes[i - order]).recip());
            let difference = WORKING.difference(&values[i], &values[i - 1]);
            values[i] = WORKING.product(&difference, &over);
        }
    }
    // Horner's scheme in the products of the distances, from the last difference on.
    let mut coefficients = vec![Ball::zero(); count];
    for i in (0..count).rev() {
        let node = WORKING.fraction(&nodes[i]);
        for k in (0..count).rev() {
            let lower = if k > 0 { coefficients[k - 1].clone() } else { values[i].clone() };
            let product = WORKING.product(&coefficients[k], &node);
            coefficients[k] = WORKING.difference(&lower, &product);
        }
    }
    coefficients
}

/// Binary digits of the series, whose errors need only be small beside the error of a law.
const DIGITS: usize = 48;

/// `r G` of the series of a force along `m + r cos(theta)`.
fn mean_rate(force: &FourierSeries) -> FourierSeries {
    let length = force.length();
    let mut cosines = vec![Ball::zero(); length.max(1)];
    // From the highest harmonic down, the sum over k = l + 1, l + 3, ... grows by a term each time; the
    // two parities take turns.
    let mut sums = [Ball::zero(), Ball::zero()];
    for l in (1..length).rev() {
        let k = l + 1;
        let sum = &mut sums[l % 2];
        if k < length {
            let divisor = u32::try_from(k * k - 1).unwrap_or(u32::MAX);
            *sum = WORKING.sum(sum, &WORKING.divided(&force.cosine(k), divisor));
        }
        cosines[l] = WORKING.scaled(sum, 4 * l as i64);
    }
    cosines[0] = force.cosine(1);
    let tail = force.tail * Bound::exactly(4.0) / 3;
    FourierSeries::exactly(cosines, vec![]).widened(tail).of_digits(DIGITS)
}

/// The mean of a series.
fn mean(series: &FourierSeries) -> Ball {
    widened(&series.cosine(0), series.tail)
}

fn widened(ball: &Ball, by: Bound) -> Ball {
    Ball { middle: ball.middle.clone(), radius: ball.radius + by }
}

/// A number and its derivative by the variable.
#[derive(Clone, Debug)]
struct Jet {
    value: Ball,
    slope: Ball,
}

impl Jet {
    fn constant(value: Ball) -> Self {
        Self { value, slope: Ball::zero() }
    }

    fn plus(&self, other: &Self) -> Self {
        Self {
            value: WORKING.sum(&self.value, &other.value),
            slope: WORKING.sum(&self.slope, &other.slope),
        }
    }

    fn times(&self, other: &Self) -> Self {
        let product = |one: &Ball, other: &Ball| WORKING.product(one, other);
        Self {
            value: product(&self.value, &other.value),
            slope: WORKING
                .sum(&product(&self.slope, &other.value), &product(&self.value, &other.slope)),
        }
    }

    fn inverse(&self) -> Option<Self> {
        let value = WORKING.quotient(&WORKING.integer(1), &self.value)?;
        let slope = WORKING.product(&WORKING.product(&value, &value), &self.slope);
        Some(Self { value, slope: WORKING.scaled(&slope, -1) })
    }

    /// A rational power, of a positive number where it is not whole.
    fn to_power(&self, exponent: &Rational) -> Option<Self> {
        let (times, degree) = (exponent.numer().abs().to_u32()?, exponent.denom().to_u32()?);
        if times > MOST_TIMES || degree > MOST_TIMES {
            return None;
        }
        let root = match degree {
            1 => self.clone(),
            _ => {
                let value = WORKING.root(&self.value, degree)?;
                // (u^(1/n))' = u' u^(1/n)/(n u).
                let slope = WORKING.quotient(&WORKING.product(&value, &self.slope), &self.value)?;
                Self { value, slope: WORKING.divided(&slope, degree) }
            }
        };
        let mut power = Self::constant(WORKING.integer(1));
        for _ in 0..times {
            power = power.times(&root);
        }
        if exponent.is_negative() { power.inverse() } else { Some(power) }
    }

    fn function(&self, function: Function) -> Option<Self> {
        let of = |function: Function| {
            let series = function_of(function, &FourierSeries::constant(self.value.clone()))?;
            Some(series.at_zero())
        };
        let value = of(function)?;
        let slope = match function {
            Function::Sin => of(Function::Cos)?,
            Function::Cos => WORKING.scaled(&of(Function::Sin)?, -1),
            Function::Exp => value.clone(),
            Function::Log => WORKING.quotient(&WORKING.integer(1), &self.value)?,
            _ => return None,
        };
        Some(Self { value, slope: WORKING.product(&slope, &self.slope) })
    }
}

/// The largest power, and degree of a root, of a law.
const MOST_TIMES: u32 = 64;

/// The variable, or r, on an interval.
struct Variable {
    place: Ball,
    from: Rational,
    to: Rational,
}

impl Variable {
    fn at(place: &Rational) -> Self {
        Self { place: WORKING.fraction(place), from: place.clone(), to: place.clone() }
    }

    fn between(from: &Rational, to: &Rational) -> Self {
        let two = Integer::from(2);
        let half = Bound::of_fraction(&((to - from) / &two));
        let place = widened(&WORKING.fraction(&((from + to) / &two)), half);
        Self { place, from: from.clone(), to: to.clone() }
    }

    /// `r^exponent` with its slope, for an exponent that is not negative.
    fn power(&self, exponent: &Rational) -> Option<Jet> {
        let jet = Jet { value: self.place.clone(), slope: WORKING.integer(1) };
        if exponent.is_zero() {
            return Some(Jet::constant(WORKING.integer(1)));
        }
        if exponent.is_integer() || self.from.is_positive() {
            return jet.to_power(exponent);
        }
        // Between zero and the power of the upper end, with a slope that is not bounded.
        let end = Jet::constant(WORKING.fraction(&self.to)).to_power(exponent)?;
        let half = WORKING.divided(&end.value, 2);
        let radius = WORKING.magnitude(&half);
        Some(Jet {
            value: widened(&half, radius),
            slope: Ball { middle: Integer::zero(), radius: Bound::UNKNOWN },
        })
    }
}

/// A number times a power of the variable of an interval, which may reach zero.
#[derive(Clone, Debug)]
struct ScaledJet {
    power: Rational,
    jet: Jet,
}

impl ScaledJet {
    /// The same number with another, smaller power; `None` if the power of the variable has no value.
    fn with_power(&self, power: &Rational, variable: &Variable) -> Option<Self> {
        let more = &self.power - power;
        let jet = match more.is_zero() {
            true => self.jet.clone(),
            false => self.jet.times(&variable.power(&more)?),
        };
        Some(Self { power: power.clone(), jet })
    }

    /// The number itself, without a power.
    fn unscaled(&self, variable: &Variable) -> Option<Jet> {
        let power = match self.power.is_negative() {
            true => variable.power(&-&self.power)?.inverse()?,
            false => variable.power(&self.power)?,
        };
        Some(self.jet.times(&power))
    }
}

/// The law with the variable in an interval, or its reciprocal.
fn law_along(
    law: &Expr,
    symbol: Symbol,
    variable: &Variable,
    is_far: bool,
) -> Result<ScaledJet, LawNotProved> {
    let unscaled = |jet: Jet| ScaledJet { power: Rational::zero(), jet };
    let value = |node: &Expr, parts: &[ScaledJet]| -> Option<ScaledJet> {
        match node.node() {
            Node::Number(value) => Some(unscaled(Jet::constant(WORKING.fraction(value)))),
            Node::Pi => Some(unscaled(Jet::constant(WORKING.pi()))),
            Node::Symbol(name) if *name == symbol => Some(match is_far {
                false => unscaled(Jet { value: variable.place.clone(), slope: WORKING.integer(1) }),
                true => ScaledJet {
                    power: Rational::from_integer((-1).into()),
                    jet: Jet::constant(WORKING.integer(1)),
                },
            }),
            Node::Symbol(_) => None,
            Node::Sum(_) => {
                let least = parts.iter().map(|part| &part.power).min()?;
                let mut aligned = parts.iter().map(|part| part.with_power(least, variable));
                let first = aligned.next()??;
                aligned.try_fold(first, |sum, part| {
                    Some(ScaledJet { power: sum.power, jet: sum.jet.plus(&part?.jet) })
                })
            }
            Node::Product(coefficient, _) => {
                let number = unscaled(Jet::constant(WORKING.fraction(coefficient)));
                Some(parts.iter().fold(number, |product, part| ScaledJet {
                    power: &product.power + &part.power,
                    jet: product.jet.times(&part.jet),
                }))
            }
            Node::Power(_, exponent) => {
                let (base, exponent) = (parts.first()?, exponent.as_number()?);
                // The root of a variable that begins at zero.
                let is_variable = node.children().next()?.as_symbol() == Some(symbol);
                if is_variable && !is_far && !variable.from.is_positive() && !exponent.is_negative()
                {
                    return Some(unscaled(variable.power(exponent)?));
                }
                Some(ScaledJet { power: &base.power * exponent, jet: base.jet.to_power(exponent)? })
            }
            Node::Function(function, _) => {
                Some(unscaled(parts.first()?.unscaled(variable)?.function(*function)?))
            }
        }
    };
    law.fold(|node, parts: &[ScaledJet]| {
        value(node, parts).ok_or_else(|| LawNotProved::NoValue(node.to_string()))
    })
}

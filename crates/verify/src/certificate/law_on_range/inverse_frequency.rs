//! `1/omega` of the motions of a range, or T/T_0 and the restitution of its contacts, enclosed: on each of
//! some pieces a polynomial in the variable with a bound of its distance from the truth.
//!
//! In: a force with a variable, and a range of it. Out: pieces, each as wide as a bound of these on
//! a disc of complex values about it allows. A piece costs some seventeen series of `G^(-1/2)`, of a
//! force that is not odd with the other turning point of each motion besides.
//!
//! With a mass M that depends on the position `G^(-1/2)` is `(M/G)^(1/2)`. Equations and sources: those of
//! `law_on_range`.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use num_traits::Zero as _;

use super::super::coordinate;
use super::super::double_series::{DoubleSeries, ball, nearest};
use super::super::force::{along_all, is_odd};
use super::super::fourier_series::WORKING;
use super::contact::{self, ContactMean};
use super::cosine_series::CosineSeries;
use super::jet::{Jet, widened};
use super::{LawNotProved, StartOfLaw};
use crate::conservative::CentredForce;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::rational::from_f64;
use crate::exact::{Integer, Rational};
use crate::expr::Expr;
use crate::interrupt::Supervision;
use crate::parallel::par_map;
use crate::symbol::Symbol;

/// The force of a law and its derivatives, in one variable.
pub(super) struct ForceOnRange {
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
    /// The variable of its pieces.
    scale: Scale,
    /// The mass, where that depends on the position.
    mass: Option<Expr>,
    /// The contact whose time the motion gives; `None` for the frequency.
    contact: Option<ContactMean>,
}

/// The variable of a piece: the variable itself, or r.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Scale {
    /// The power d of r with which `r^d f` has a value at r = 0; zero in the variable itself.
    pub(super) power: u32,
    /// Whether the variable is r.
    pub(super) is_far: bool,
}

impl Scale {
    /// The variable itself.
    pub(super) const OWN: Self = Self { power: 0, is_far: false };
}

/// `1/omega`, or T/T_0 and the restitution, on a part of the range.
pub(super) struct TruthPiece {
    /// The turning points of a motion of the piece, where they are needed for those of others.
    pub(super) turns: Option<Turns>,
    pub(super) scale: Scale,
    pub(super) middle: Rational,
    pub(super) half: Rational,
    pub(super) truth: PiecePolynomial,
    /// The restitution of a contact; `None` for a frequency.
    pub(super) restitution: Option<PiecePolynomial>,
}

/// A quantity on a part of the range, as a polynomial in `e = (v - middle)/half`.
pub(super) struct PiecePolynomial {
    /// Its coefficients, the constant first.
    coefficients: Vec<Ball>,
    /// The coefficients of the polynomial in Chebyshev's polynomials.
    chebyshev: Vec<Ball>,
    /// Bound of the distance of the quantity from the polynomial.
    pub(super) remainder: Bound,
}

impl PiecePolynomial {
    /// The polynomial with these coefficients, the constant first.
    pub(super) fn new(coefficients: Vec<Ball>, remainder: Bound) -> Self {
        let chebyshev = in_chebyshev_polynomials(&coefficients);
        Self { coefficients, chebyshev, remainder }
    }

    /// The value of the polynomial.
    pub(super) fn value(&self, e: &Ball) -> Ball {
        self.coefficients.iter().rev().fold(Ball::zero(), |value, coefficient| {
            WORKING.sum(&WORKING.product(&value, e), coefficient)
        })
    }

    /// All numbers of the ball that a value may be.
    pub(super) fn within(&self, e: &Ball, half: &Rational) -> Jet {
        let own = self.at(e, half);
        Jet { value: widened(&own.value, self.remainder), ..own }
    }

    /// The series of Chebyshev of the quantity on the piece.
    pub(super) fn series<S: CosineSeries>(&self) -> S {
        S::of_balls(self.chebyshev.clone()).widened(self.remainder)
    }

    /// The polynomial and its derivative by the variable, on a piece of this half width.
    pub(super) fn at(&self, e: &Ball, half: &Rational) -> Jet {
        let (mut value, mut slope) = (Ball::zero(), Ball::zero());
        for coefficient in self.coefficients.iter().rev() {
            slope = WORKING.sum(&WORKING.product(&slope, e), &value);
            value = WORKING.sum(&WORKING.product(&value, e), coefficient);
        }
        let slope = WORKING.quotient(&slope, &WORKING.fraction(half));
        let slope = slope.unwrap_or(Ball { middle: Integer::zero(), radius: Bound::UNKNOWN });
        Jet { value, slope }
    }
}

/// The coefficients of a polynomial in Chebyshev's polynomials, by Horner's scheme: `2 x T_j = T_(j + 1) + T_|j - 1|`.
fn in_chebyshev_polynomials(coefficients: &[Ball]) -> Vec<Ball> {
    let mut sum: Vec<Ball> = vec![];
    for coefficient in coefficients.iter().rev() {
        let mut next = vec![Ball::zero(); sum.len() + 1];
        for (j, own) in sum.iter().enumerate() {
            let (own, half) = (own, WORKING.divided(own, 2));
            let both: &[(usize, &Ball)] = match j {
                0 => &[(1, own)],
                _ => &[(j + 1, &half), (j - 1, &half)],
            };
            for (place, part) in both {
                next[*place] = WORKING.sum(&next[*place], part);
            }
        }
        next[0] = WORKING.sum(&next[0], coefficient);
        sum = next;
    }
    sum
}

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
pub(super) struct Extent {
    pub(super) middle: Ball,
    pub(super) radius: Ball,
}

/// The turning points of a motion, to the digits of doubles: those of others near it are alike.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turns {
    start: f64,
    end: f64,
}

/// G on a disc of complex values of the variable.
struct RateOnDisc<S> {
    rate: S,
    /// The motions of the disc.
    extent: Extent,
    /// Their other turning points.
    end: Ball,
}

impl ForceOnRange {
    pub(super) fn new(
        start: &StartOfLaw,
        variable: Symbol,
        force: Expr,
        scale: Scale,
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
        let (mass, contact) = (None, None);
        Ok(Self {
            start,
            variable,
            force,
            by_place,
            is_odd,
            slope,
            curvature,
            bend,
            scale,
            mass,
            contact,
        })
    }

    /// The force of `M x'' + (dM/dx) x'^2/2 + f = 0`.
    pub(super) fn with_mass(self, mass: Option<&Expr>) -> Self {
        Self { mass: mass.cloned(), ..self }
    }

    /// The swing whose mean is the time of a contact.
    pub(super) fn of_contact(contact: ContactMean, variable: Symbol) -> Result<Self, LawNotProved> {
        let swing = Self::new(&StartOfLaw::Variable, variable, contact::force()?, Scale::OWN)?;
        Ok(Self { contact: Some(contact), ..swing })
    }

    /// The pieces of a range, each as wide as a bound on a disc about it allows.
    pub(super) fn pieces<S: CosineSeries>(
        &self,
        from: &Rational,
        to: &Rational,
        supervision: Supervision,
    ) -> Result<Vec<TruthPiece>, LawNotProved> {
        let steps = 1_u32 << THINNEST;
        let place =
            |position: u32| from + (to - from) * Rational::new(position.into(), steps.into());
        let (mut position, mut width, mut turns) = (0, steps / 4, None);
        let mut pieces = vec![];
        while position < steps {
            if supervision.interrupt.is_requested() {
                return Err(LawNotProved::Stopped);
            }
            let next = (position + width).min(steps);
            match self.piece::<S>([&place(position), &place(next)], turns) {
                Ok(piece) => {
                    turns = piece.turns;
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

    /// The quantities between two places: the polynomials through their values at points like those of
    /// Chebyshev. With `|1/omega| <= M` on the disc of radius rho about the middle and `|v - middle| <=
    /// h`, it is off by at most `M rho/(rho - h) max |w(v)|/(rho - h)^n`, w the product of the distances
    /// from the points.
    fn piece<S: CosineSeries>(
        &self,
        [from, to]: [&Rational; 2],
        near: Option<Turns>,
    ) -> Result<TruthPiece, LawNotProved> {
        let two = Integer::from(2);
        let (middle, half) = ((from + to) / &two, (to - from) / &two);
        let radius = &half * Integer::from(WIDER);
        let begins_at_rest = self.start == StartOfLaw::Variable && from.is_zero();
        let turns = match self.is_odd {
            true => None,
            false => {
                let place = WORKING.fraction(&middle);
                let [start, _] = self.start::<S>(&place)?;
                let end = self.turning_point::<S>(&place, &start, near)?;
                Some(Turns { start: nearest(&start), end: nearest(&end) })
            }
        };
        let largest = match begins_at_rest {
            true => self.bound_about_rest::<S>(&(&radius + &middle))?,
            false => self.bound_on_disc::<S>(&middle, &radius, turns)?,
        };
        let place = |node: &Rational| WORKING.fraction(&(&middle + &half * node));
        let values = par_map(&INTERPOLATION.nodes, |node| self.truth::<S>(&place(node), turns));
        let values = values.into_iter().collect::<Result<Vec<Vec<Ball>>, _>>()?;
        let quantity = |number: usize, largest: &Bound| {
            let values: Vec<&Ball> = values.iter().filter_map(|all| all.get(number)).collect();
            let (coefficients, uncertainty) = INTERPOLATION.polynomial(&values);
            let remainder = interpolation_error(*largest, INTERPOLATION.largest_product);
            PiecePolynomial::new(coefficients, remainder + uncertainty)
        };
        let mut quantities = largest.iter().enumerate().map(|(i, bound)| quantity(i, bound));
        let none = || LawNotProved::NoValue("1/omega".to_owned());
        let truth = quantities.next().ok_or_else(none)?;
        let restitution = quantities.next();
        Ok(TruthPiece { turns, scale: self.scale, middle, half, truth, restitution })
    }

    /// x(0) with the variable in a ball, and its derivative by the variable.
    fn start<S: CosineSeries>(&self, variable: &Ball) -> Result<[Ball; 2], LawNotProved> {
        match (&self.contact, &self.start) {
            (Some(contact), _) => {
                let none = || LawNotProved::NoValue("log(1 + c*v)".to_owned());
                contact.start::<S>(variable).ok_or_else(none)
            }
            (None, StartOfLaw::Variable) => Ok([variable.clone(), WORKING.integer(1)]),
            (None, StartOfLaw::Fixed(start)) => Ok([WORKING.fraction(start), Ball::zero()]),
        }
    }

    /// An expression along a motion with the variable in a ball; the second extent is the derivative
    /// of the first by the variable.
    fn along<S: CosineSeries>(
        &self,
        expression: &Expr,
        variable: &Ball,
        [extent, change]: [&Extent; 2],
    ) -> Result<S, LawNotProved> {
        let series =
            |extent: &Extent| S::of_balls(vec![extent.middle.clone(), extent.radius.clone()]);
        let (motion, change) = (series(extent), series(change));
        let variable = S::constant(variable.clone());
        let letters = [(coordinate(), &motion), (moving(), &change), (self.variable, &variable)];
        Ok(along_all(expression, &letters)?)
    }

    /// An expression at a place of the coordinate.
    fn at<S: CosineSeries>(
        &self,
        expression: &Expr,
        variable: &Ball,
        place: &Ball,
    ) -> Result<Ball, LawNotProved> {
        let there = Extent { middle: place.clone(), radius: Ball::zero() };
        let nothing = Extent::of_odd(Ball::zero());
        Ok(self.along::<S>(expression, variable, [&there, &nothing])?.at_zero())
    }

    /// The stiffness at rest, a constant.
    fn stiffness<S: CosineSeries>(&self, variable: &Ball) -> Result<S, LawNotProved> {
        Ok(S::constant(self.at::<S>(&self.by_place, variable, &Ball::zero())?))
    }

    /// The motion at a value of the variable.
    fn extent<S: CosineSeries>(
        &self,
        place: &Ball,
        near: Option<Turns>,
    ) -> Result<Extent, LawNotProved> {
        let [start, _] = self.start::<S>(place)?;
        match self.is_odd {
            true => Ok(Extent::of_odd(start)),
            false => {
                let end = self.turning_point::<S>(place, &start, near)?;
                Ok(Extent::between(&start, &end))
            }
        }
    }

    /// The other turning point: a number in doubles, improved by Newton's iteration on `V(a) - V(b)`,
    /// whose derivative by b is -f(b), and then the interval in which that has its zero.
    fn turning_point<S: CosineSeries>(
        &self,
        place: &Ball,
        start: &Ball,
        near: Option<Turns>,
    ) -> Result<Ball, LawNotProved> {
        let none = || LawNotProved::NoValue("the turning point".to_owned());
        let own = || {
            let numbers = BTreeMap::from([(self.variable, WORKING.nearest(place))]);
            let from = nearest(start);
            let force = CentredForce::new(&self.force, coordinate(), &Expr::zero(), &numbers, from);
            force.and_then(|force| force.turning_point(from).ok())
        };
        let end = near.and_then(|near| self.turning_point_near(place, start, near)).or_else(own);
        let mut end = WORKING.fraction(&end.and_then(from_f64).ok_or_else(none)?);
        let nothing = Extent::of_odd(Ball::zero());
        let mut work = Ball::zero();
        for step in 0..=S::STEPS_FROM_DOUBLES {
            let extent = Extent::between(start, &end);
            let series = self.along::<S>(&self.force, place, [&extent, &nothing])?;
            work = WORKING.product(&work_between(&series), &WORKING.scaled(&extent.radius, 2));
            if step < S::STEPS_FROM_DOUBLES {
                let force = self.at::<S>(&self.force, place, &end)?;
                let more = WORKING.quotient(&work, &force).ok_or_else(none)?;
                end = widened(&WORKING.sum(&end, &more), Bound::ZERO);
                end.radius = Bound::ZERO;
            }
        }
        let force = WORKING.distance_from_zero(&self.at::<S>(&self.force, place, &end)?);
        let distance = WORKING.magnitude(&work).over(force) * Bound::exactly(2.0);
        let around = widened(&end, distance);
        let least = WORKING.distance_from_zero(&self.at::<S>(&self.force, place, &around)?);
        match WORKING.magnitude(&work).over(least) < distance {
            true => Ok(around),
            false => Err(none()),
        }
    }

    /// Finds the other turning point in doubles, by Newton's iteration from that of another motion; `None` if it does not
    /// converge.
    fn turning_point_near(&self, place: &Ball, start: &Ball, near: Turns) -> Option<f64> {
        const STEPS: usize = 12;
        /// A step after which the next one would be one of rounding.
        const ENOUGH: f64 = 1e-8;
        let from = nearest(start);
        let mut end = near.end * (from / near.start);
        let nothing = Extent::of_odd(Ball::zero());
        for _ in 0..STEPS {
            let there = ball(end, Bound::ZERO);
            let extent = Extent::between(start, &there);
            let series =
                self.along::<DoubleSeries>(&self.force, place, [&extent, &nothing]).ok()?;
            let work = nearest(&work_between(&series)) * (from - end);
            let more = work / series.at_pi();
            end += more;
            if end.signum() == from.signum() || !end.is_finite() {
                return None;
            }
            if more.abs() <= ENOUGH * end.abs() {
                return Some(end);
            }
        }
        None
    }

    /// `1/omega` at a place that is not rest, or T/T_0 and the restitution.
    pub(super) fn truth<S: CosineSeries>(
        &self,
        place: &Ball,
        near: Option<Turns>,
    ) -> Result<Vec<Ball>, LawNotProved> {
        let extent = self.extent::<S>(place, near)?;
        let nothing = Extent::of_odd(Ball::zero());
        let rate = self.along::<S>(&self.force, place, [&extent, &nothing])?.mean_rate();
        let rate = rate.over(&extent.radius);
        let root = self.root(&rate.ok_or_else(|| LawNotProved::NoValue("1/A".to_owned()))?)?;
        let root = self.with_root_of_mass(root, place, &extent)?;
        let Some(contact) = &self.contact else { return Ok(vec![mean(&root)]) };
        let end = WORKING.difference(&extent.middle, &extent.radius);
        let values = contact.values(&root, (&extent, &end), place);
        Ok(values.ok_or_else(|| LawNotProved::NoValue("T/T_0".to_owned()))?.to_vec())
    }

    /// The quantities in the limit of small amplitudes.
    pub(super) fn at_rest<S: CosineSeries>(&self) -> Result<Vec<Ball>, LawNotProved> {
        match &self.contact {
            Some(_) => Ok(vec![WORKING.integer(1); 2]),
            None => {
                let (nowhere, still) = (Ball::zero(), Extent::of_odd(Ball::zero()));
                let root = self.root::<S>(&self.stiffness(&nowhere)?)?;
                Ok(vec![mean(&self.with_root_of_mass(root, &nowhere, &still)?)])
            }
        }
    }

    /// A series times the root of the mass along a motion.
    fn with_root_of_mass<S: CosineSeries>(
        &self,
        series: S,
        variable: &Ball,
        extent: &Extent,
    ) -> Result<S, LawNotProved> {
        let Some(mass) = &self.mass else { return Ok(series) };
        let nothing = Extent::of_odd(Ball::zero());
        Ok(series.product(&root_of_mass(&self.along(mass, variable, [extent, &nothing])?)?))
    }

    /// `G^(-1/2)`, or the power that is that of the contact.
    fn root<S: CosineSeries>(&self, rate: &S) -> Result<S, LawNotProved> {
        let rate = rate.clone().of_kept_digits();
        let root = match &self.contact {
            Some(contact) => contact.weighted(&rate),
            None => rate.inverse_root(2),
        };
        root.ok_or_else(|| LawNotProved::NoValue("G^(-1/2)".to_owned()))
    }

    /// Bounds of the sizes of the quantities for all complex values of the variable within a distance of
    /// one: by the mean value theorem, whose norms hold for complex numbers too.
    fn bound_on_disc<S: CosineSeries>(
        &self,
        middle: &Rational,
        radius: &Rational,
        near: Option<Turns>,
    ) -> Result<Vec<Bound>, LawNotProved> {
        let (place, spread) = (WORKING.fraction(middle), Bound::of_fraction(radius));
        let all = widened(&place, spread);
        let [start, _] = self.start::<S>(&all)?;
        let of_odd = |rate: S| RateOnDisc {
            rate,
            extent: Extent::of_odd(start.clone()),
            end: WORKING.scaled(&start, -1),
        };
        let on_disc = match (self.is_odd, &self.start) {
            (false, _) => self.rate_on_disc(&place, &all, spread, near)?,
            (true, StartOfLaw::Fixed(_)) => of_odd(self.rate_by_parameter(&place, &all, spread)?),
            (true, StartOfLaw::Variable) => of_odd(self.rate_by_amplitude(&place, &all, spread)?),
        };
        let root = self.with_root_of_mass(self.root(&on_disc.rate)?, &all, &on_disc.extent)?;
        let Some(contact) = &self.contact else { return Ok(vec![root.norm()]) };
        let bounds = contact.bounds(&root, (&on_disc.extent, &on_disc.end), &all);
        Ok(bounds.ok_or_else(|| LawNotProved::NoValue("T/T_0".to_owned()))?.to_vec())
    }

    /// G on a disc of a parameter, of an odd force whose motion has one amplitude.
    fn rate_by_parameter<S: CosineSeries>(
        &self,
        place: &Ball,
        all: &Ball,
        spread: Bound,
    ) -> Result<S, LawNotProved> {
        let (extent, nothing) = (self.extent::<S>(place, None)?, Extent::of_odd(Ball::zero()));
        let at = |expression: &Expr, variable: &Ball| {
            self.along::<S>(expression, variable, [&extent, &nothing])
        };
        let over = |series: S| {
            let rate = series.mean_rate().over(&extent.radius);
            rate.ok_or_else(|| LawNotProved::NoValue("1/A".to_owned()))
        };
        let slope = at(&self.slope, place)?.widened(spread * at(&self.curvature, all)?.norm());
        Ok(over(at(&self.force, place)?)?.widened(spread * over(slope)?.norm()))
    }

    /// G on a disc of amplitudes, of an odd force: `G = f'(0) + L[g]/a` with `g = f - f'(0) x`, whose terms
    /// are of the size a^3.
    fn rate_by_amplitude<S: CosineSeries>(
        &self,
        place: &Ball,
        all: &Ball,
        spread: Bound,
    ) -> Result<S, LawNotProved> {
        let change = Extent::of_odd(WORKING.integer(1));
        let at = |expression: &Expr, variable: &Ball| {
            let extent = Extent::of_odd(variable.clone());
            self.along::<S>(expression, variable, [&extent, &change])
        };
        let stiffness: S = self.stiffness(place)?;
        let subtracted = |series: S, size: &Ball| {
            let line = S::of_balls(vec![Ball::zero(), size.clone()]);
            series.difference(&line.product(&stiffness))
        };
        let slope = at(&self.slope, place)?.widened(spread * at(&self.curvature, all)?.norm());
        let own = subtracted(at(&self.force, place)?, place);
        let slope = subtracted(slope, &WORKING.integer(1));
        let own_on_all = own.clone().widened(spread * slope.norm());
        let over = |series: &S, by: &Ball| {
            let rate = series.mean_rate().over(by);
            rate.ok_or_else(|| LawNotProved::NoValue("1/A".to_owned()))
        };
        let rate = stiffness.sum(&over(&own, place)?);
        let square = WORKING.product(all, all);
        let by_variable = over(&slope, all)?.difference(&over(&own_on_all, &square)?);
        Ok(rate.widened(spread * by_variable.norm()))
    }

    /// G on a disc, of a force that is not odd: the other turning point b moves by
    /// `b' = (f(a) a' + int_b^a f_p dx)/f(b)`, which is bounded on a disc about it that it does not leave.
    fn rate_on_disc<S: CosineSeries>(
        &self,
        place: &Ball,
        all: &Ball,
        spread: Bound,
        near: Option<Turns>,
    ) -> Result<RateOnDisc<S>, LawNotProved> {
        let none = || LawNotProved::NoValue("the turning point".to_owned());
        let ([start, _], [start_on_all, change]) = (self.start::<S>(place)?, self.start::<S>(all)?);
        let end = self.turning_point::<S>(place, &start, near)?;
        let nothing = Extent::of_odd(Ball::zero());
        let by_variable = self.force.differentiate(self.variable)?;
        let rate_of_end = |end_on_all: &Ball| -> Result<Ball, LawNotProved> {
            let extent = Extent::between(&start_on_all, end_on_all);
            let by_variable = self.along::<S>(&by_variable, all, [&extent, &nothing])?.norm();
            let length = WORKING.magnitude(&extent.radius) * Bound::exactly(2.0);
            let force = WORKING.product(&self.at::<S>(&self.force, all, &start_on_all)?, &change);
            let work = widened(&force, length * by_variable);
            WORKING.quotient(&work, &self.at::<S>(&self.force, all, end_on_all)?).ok_or_else(none)
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
        let force: S = self.along(&self.force, place, [&extent, &nothing])?;
        let slope: S = self.along(&self.slope, all, [&on_all, &change])?;
        let force_on_all = force.clone().widened(spread * slope.norm());
        let over = |series: &S, by: &Ball| series.mean_rate().over(by).ok_or_else(none);
        let square = WORKING.product(&on_all.radius, &on_all.radius);
        let turned = S::constant(change.radius.clone());
        let by_variable = over(&slope, &on_all.radius)?
            .difference(&over(&force_on_all, &square)?.product(&turned));
        let rate = over(&force, &extent.radius)?.widened(spread * by_variable.norm());
        Ok(RateOnDisc { rate, extent: on_all, end: end_on_all })
    }

    /// Bounds of the sizes of the quantities for all complex amplitudes up to a size R: `f(x) = f'(0) x + g(x)` with
    /// `|g| <= |x|^2 M/2`, M a bound of f'' on `|x| <= 2 R`.
    ///
    /// ```text
    /// f odd:  |G - f'(0)| <= R M/2
    /// else:   V = f'(0) x^2/2 (1 + e(x)),  |e| <= e_0 = 2 R M/(3 f'(0)),   b = -v u,  u^2 = (1 + e(v))/(1 + e(b)),
    ///         |u - 1| <= w = 2 e_0/(1 - e_0) <= 1,    |G - f'(0)| <= (2/3) R M (1 + w)^2/(1 - w/2)
    /// ```
    fn bound_about_rest<S: CosineSeries>(
        &self,
        size: &Rational,
    ) -> Result<Vec<Bound>, LawNotProved> {
        let spread = match &self.contact {
            Some(contact) => Bound::of_fraction(&contact.largest_start(size)),
            None => Bound::of_fraction(size),
        };
        let stiffness: S = self.stiffness(&Ball::zero())?;
        let nothing = Extent::of_odd(Ball::zero());
        let bend = |size: Bound| -> Result<Bound, LawNotProved> {
            let all = Extent::of_odd(widened(&Ball::zero(), size));
            Ok(self.along::<S>(&self.bend, &Ball::zero(), [&all, &nothing])?.norm())
        };
        let (distance, w) = match self.is_odd {
            true => (spread * bend(spread)? / 2, Bound::ZERO),
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
                (third.over((w / 2).below_complement()), w)
            }
        };
        let root = self.root(&stiffness.widened(distance))?;
        // Both turning points are within 2 R of rest, and the coefficients of the motion within 3 R in all.
        let motion = S::constant(Ball::zero()).widened(spread * Bound::exactly(3.0));
        let root = match self
            .mass
            .as_ref()
            .map(|mass| along_all(mass, &[(coordinate(), &motion)]))
            .transpose()?
        {
            Some(mass) => root.product(&root_of_mass(&mass)?),
            None => root,
        };
        let Some(contact) = &self.contact else { return Ok(vec![root.norm()]) };
        let bounds = contact.bounds_about_rest(&root, w, size);
        Ok(bounds.ok_or_else(|| LawNotProved::NoValue("T/T_0".to_owned()))?.to_vec())
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
fn work_between(force: &impl CosineSeries) -> Ball {
    let mut sum = force.cosine(0);
    for k in (2..force.length()).step_by(2) {
        let divisor = u32::try_from(k * k - 1).unwrap_or(u32::MAX);
        sum = WORKING.difference(&sum, &WORKING.divided(&force.cosine(k), divisor));
    }
    widened(&sum, force.tail())
}

/// `M^(1/2)`.
fn root_of_mass<S: CosineSeries>(mass: &S) -> Result<S, LawNotProved> {
    let inverse = mass.inverse_root(2);
    let inverse = inverse.ok_or_else(|| LawNotProved::NoValue("M^(1/2)".to_owned()))?;
    Ok(mass.product(&inverse))
}

/// Polynomials through values at the nodes of a piece.
struct Interpolation {
    /// Fractions near the points of Chebyshev between -1 and 1.
    nodes: Vec<Rational>,
    /// A bound of `prod |e - e_j|`.
    largest_product: Bound,
    /// The polynomials that are one at one node and zero at the others, their constants first.
    basis: Vec<Vec<Ball>>,
    /// Bounds of their sizes.
    sizes: Vec<Bound>,
}

static INTERPOLATION: LazyLock<Interpolation> = LazyLock::new(|| {
    let node = |i: usize| {
        let angle = std::f64::consts::PI * (i as f64 + 0.5) / NODES as f64;
        Rational::new(((angle.cos() * 65536.0).round() as i64).into(), 65536.into())
    };
    let nodes: Vec<Rational> = (0..NODES).map(node).collect();
    let largest_product = largest_product(&nodes);
    let one_at = |i: usize| {
        let mut values = vec![Ball::zero(); NODES];
        values[i] = WORKING.integer(1);
        interpolated(&nodes, values)
    };
    let basis: Vec<Vec<Ball>> = (0..NODES).map(one_at).collect();
    let size = |coefficients: &Vec<Ball>| {
        in_chebyshev_polynomials(coefficients).iter().map(|ball| WORKING.magnitude(ball)).sum()
    };
    let sizes = basis.iter().map(size).collect();
    Interpolation { nodes, largest_product, basis, sizes }
});

impl Interpolation {
    /// The polynomial through the middles of values at the nodes, and a bound of its distance from that through
    /// any other numbers of their balls.
    fn polynomial(&self, values: &[&Ball]) -> (Vec<Ball>, Bound) {
        let mut coefficients = vec![Ball::zero(); NODES];
        let mut uncertainty = Bound::ZERO;
        for ((value, basis), size) in values.iter().zip(&self.basis).zip(&self.sizes) {
            let middle = Ball { middle: value.middle.clone(), radius: Bound::ZERO };
            for (coefficient, own) in coefficients.iter_mut().zip(basis) {
                *coefficient = WORKING.sum(coefficient, &WORKING.product(own, &middle));
            }
            uncertainty += value.radius * *size;
        }
        (coefficients, uncertainty)
    }
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

/// A bound of the distance of a function from the polynomial through its values at the nodes, from one of its
/// size on the disc and of the product of the distances from the nodes in units of h.
fn interpolation_error(largest: Bound, largest_product: Bound) -> Bound {
    let outside = f64::from(WIDER - 1);
    let apart = (0..NODES).fold(largest_product, |bound, _| bound.over(outside));
    Bound::exactly(f64::from(WIDER)).over(outside) * apart * largest
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

/// The mean of a series.
fn mean(series: &impl CosineSeries) -> Ball {
    widened(&series.cosine(0), series.tail())
}

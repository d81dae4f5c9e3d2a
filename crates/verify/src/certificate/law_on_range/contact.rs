//! The contact that loses energy, as a motion that conserves it.
//!
//! The contact of Hunt and Crossley, touched with the speed v, is `d'' + k d^n (1 + c d') = 0` from d = 0
//! until d = 0 again. With `y = log(1 + c d')` it is a swing between the turning points `a = log(1 + c v)` and
//! `b = log(1 - e c v)` of the force `exp(y) - 1`, e the coefficient of restitution, and its duration T is to
//! that of the contact without damping, T_0, as
//!
//! ```text
//! V(y) = exp(y) - 1 - y:     k c^2 d^m/m = V(a) - V(y),     m = n + 1,   nu = n/m,   s = 1 - 2 nu
//! T/T_0 = (r/(c v))^s mean_s of G^(-nu),                    r, G as of a swing between a and b
//! mean_s of cos(k theta) = M_k, with the weight sin(theta)^s:  M_0 = 1,  M_1 = 0,  M_(k + 2) = M_k (k - s)/(k + 2 + s)
//! e = (1 - exp(b))/(c v)
//! ```
//!
//! In: a force `k x^n (1 + c x')`. Out: n and c, and T/T_0 and e of a swing in balls.
//!
//! Sources: K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440, for the contact; DLMF 5.12.5 for the
//! means.

use num_traits::{Signed as _, ToPrimitive as _};

use super::super::coordinate;
use super::super::force::function_of;
use super::super::fourier_series::WORKING;
use super::cosine_series::CosineSeries;
use super::inverse_frequency::Extent;
use super::jet::{Jet, LawValues as _, widened};
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::{Integer, Rational};
use crate::expr::{Expr, ExprError, Function, Node};
use crate::symbol::Symbol;

/// The force of a contact that loses energy.
#[derive(Clone, Debug, PartialEq)]
pub struct HuntCrossleyForce {
    /// The exponent n > 0 of the depth.
    pub exponent: Rational,
    /// The damping c, an expression without the depth.
    pub damping: Expr,
}

impl HuntCrossleyForce {
    /// The exponent and the damping of a force `k x^n (1 + c x')`, in which `max(x, 0)` may stand for x;
    /// `None` if it is not of this form.
    ///
    /// # Errors
    /// A force that cannot be differentiated or written.
    ///
    /// ```
    /// # use lindstedt_verify as lindstedt;
    /// use lindstedt::certificate::HuntCrossleyForce;
    ///
    /// let force = "k*max(x,0)^(3/2)*(1 + lambda*x')".parse()?;
    /// let contact = HuntCrossleyForce::of(&force, "x".into())?.ok_or("another form")?;
    /// assert_eq!(contact.exponent.to_string(), "3/2");
    /// assert_eq!(contact.damping.to_string(), "lambda");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(force: &Expr, coordinate: Symbol) -> Result<Option<Self>, ExprError> {
        let [depth, speed] = [coordinate, coordinate.derivative()].map(Expr::from);
        let force = in_contact(force, coordinate)?;
        let vanishes = |expression: Expr| expression.expand().map(|expanded| expanded.is_zero());
        let elastic = force.substitute(speed_of(coordinate), &Expr::zero())?;
        let by_speed = force.differentiate(speed_of(coordinate))?;
        if !force.contains(speed_of(coordinate)) || by_speed.contains(speed_of(coordinate)) {
            return Ok(None);
        }
        let at_depth_one = |expression: &Expr| expression.substitute(coordinate, &Expr::one());
        // x F' = n F.
        let slope = elastic.differentiate(coordinate)?;
        let exponent = Expr::divide(&at_depth_one(&slope)?, &at_depth_one(&elastic)?)?.expand()?;
        let Some(exponent) = exponent.as_number().filter(|n| n.is_positive()).cloned() else {
            return Ok(None);
        };
        let damping = Expr::divide(&at_depth_one(&by_speed)?, &at_depth_one(&elastic)?)?;
        let is_power =
            vanishes(&depth * &slope - Expr::number(exponent.clone()) * elastic.clone())?;
        let is_product = vanishes(&force - &elastic * (Expr::one() + &damping * &speed))?;
        Ok((is_power && is_product).then_some(Self { exponent, damping }))
    }
}

fn speed_of(coordinate: Symbol) -> Symbol {
    coordinate.derivative()
}

/// A force with x in place of `max(x, 0)`.
fn in_contact(force: &Expr, coordinate: Symbol) -> Result<Expr, ExprError> {
    force.fold(|node, parts: &[Expr]| match node.node() {
        Node::Function(Function::Maximum, _)
            if parts.iter().any(Expr::is_zero)
                && parts.iter().any(|part| part.as_symbol() == Some(coordinate)) =>
        {
            Ok(Expr::from(coordinate))
        }
        _ => node.with_children(parts),
    })
}

/// T/T_0 and e of a swing between two turning points.
pub(super) struct ContactMean {
    /// nu as a quotient of whole numbers.
    power: [u32; 2],
    /// s.
    weight: Rational,
    /// c.
    damping: Rational,
}

/// The largest numerator and denominator of nu.
const MOST: u32 = 64;

impl ContactMean {
    /// The mean for an exponent and a damping; `None` if the damping is not positive, or the exponent no
    /// quotient of small numbers.
    pub(super) fn new(exponent: &Rational, damping: &Rational) -> Option<Self> {
        let one = Rational::from_integer(1.into());
        let power = exponent / (exponent + &one);
        let weight = one - &power * Integer::from(2);
        let small = |number: &Integer| number.to_u32().filter(|number| *number <= MOST);
        let power = [small(power.numer())?, small(power.denom())?];
        let is_positive = exponent.is_positive() && damping.is_positive();
        is_positive.then(|| Self { power, weight, damping: damping.clone() })
    }

    /// c v, and `a = log(1 + c v)` with its derivative by v.
    pub(super) fn start<S: CosineSeries>(&self, speed: &Ball) -> Option<[Ball; 2]> {
        let damping = WORKING.fraction(&self.damping);
        let whole = WORKING.sum(&WORKING.integer(1), &WORKING.product(&damping, speed));
        let log = function_of(Function::Log, &S::constant(whole.clone()))?;
        Some([log.at_zero(), WORKING.quotient(&damping, &whole)?])
    }

    fn scaled(&self, speed: &Ball) -> Ball {
        WORKING.product(&WORKING.fraction(&self.damping), speed)
    }

    /// `G^(-nu)`.
    pub(super) fn weighted<S: CosineSeries>(&self, rate: &S) -> Option<S> {
        let [times, degree] = self.power;
        Some(rate.inverse_root(degree)?.power(times))
    }

    /// T/T_0 and e of a swing with this `G^(-nu)`, to the turning point b.
    pub(super) fn values<S: CosineSeries>(
        &self,
        weighted: &S,
        (extent, end): (&Extent, &Ball),
        speed: &Ball,
    ) -> Option<[Ball; 2]> {
        let scaled = self.scaled(speed);
        let ratio = Jet::constant(WORKING.quotient(&extent.radius, &scaled)?);
        let factor = ratio.to_power(&self.weight)?.value;
        let duration = WORKING.product(&factor, &self.mean(weighted));
        Some([duration, self.restitution::<S>(end, &scaled)?])
    }

    /// Bounds of |T/T_0| and |e| on a disc of complex speeds.
    pub(super) fn bounds<S: CosineSeries>(
        &self,
        weighted: &S,
        (extent, end): (&Extent, &Ball),
        speed: &Ball,
    ) -> Option<[Bound; 2]> {
        let scaled = self.scaled(speed);
        // |w^s| is at most |w| or one for an exponent between zero and one.
        let ratio = match self.weight.is_negative() {
            true => WORKING.quotient(&scaled, &extent.radius)?,
            false => WORKING.quotient(&extent.radius, &scaled)?,
        };
        let factor = WORKING.magnitude(&ratio).max(Bound::exactly(1.0));
        let restitution = self.restitution::<S>(end, &scaled)?;
        Some([factor * weighted.norm(), WORKING.magnitude(&restitution)])
    }

    /// The largest |a| for all complex speeds up to this size, `-log(1 - q) <= q/(1 - q)`, q = c v.
    pub(super) fn largest_start(&self, speed: &Rational) -> Rational {
        let scaled = &self.damping * speed;
        let left = Rational::from_integer(1.into()) - &scaled;
        match left.is_positive() {
            true => scaled / left,
            false => Rational::from_integer(1_000.into()),
        }
    }

    /// Bounds of |T/T_0| and |e| for all complex speeds up to this size, with `b = -a u`, `|u - 1| <= w <= 1`:
    ///
    /// ```text
    /// q = |c v|:   |log(1 + q)/q| between 1 - q/(2 (1 - q)) and 1/(1 - q),   r/q = (log(1 + q)/q) (1 + u)/2
    /// |1 - exp(b)| <= |b| exp(|b|),  exp(t) <= 1/(1 - t)
    /// ```
    pub(super) fn bounds_about_rest(
        &self,
        weighted: &impl CosineSeries,
        w: Bound,
        speed: &Rational,
    ) -> Option<[Bound; 2]> {
        let one = Bound::exactly(1.0);
        let scaled = Bound::of_fraction(&(&self.damping * speed));
        let left = scaled.below_complement();
        // Of either sign of s: r/q has no zero, so that its power is analytic.
        let largest = one.over((scaled / 2).over(left).below_complement());
        let largest = largest.over((w / 2).below_complement());
        if largest >= Bound::UNKNOWN {
            return None;
        }
        let ratio = match self.weight.is_negative() {
            true => largest,
            false => one.over(left) * (one + w / 2),
        };
        let end = Bound::of_fraction(&self.largest_start(speed)) * (one + w);
        let restitution = (one + w).over(left).over(end.below_complement());
        let bounds = [ratio.max(one) * weighted.norm(), restitution];
        bounds.iter().all(|bound| *bound < Bound::UNKNOWN).then_some(bounds)
    }

    fn restitution<S: CosineSeries>(&self, end: &Ball, scaled: &Ball) -> Option<Ball> {
        let exponential = function_of(Function::Exp, &S::constant(end.clone()))?;
        let lost = WORKING.difference(&WORKING.integer(1), &exponential.at_zero());
        WORKING.quotient(&lost, scaled)
    }

    /// The mean of a series with the weight; no |M_k| is larger than one.
    fn mean(&self, series: &impl CosineSeries) -> Ball {
        let whole = |k: usize| Rational::from_integer(Integer::from(k as u64));
        let (mut sum, mut moment) = (Ball::zero(), WORKING.integer(1));
        for k in (0..series.length()).step_by(2) {
            sum = WORKING.sum(&sum, &WORKING.product(&series.cosine(k), &moment));
            let next = (whole(k) - &self.weight) / (whole(k + 2) + &self.weight);
            moment = WORKING.product(&moment, &WORKING.fraction(&next));
        }
        widened(&sum, series.tail())
    }
}

/// The force of the swing.
pub(super) fn force() -> Result<Expr, ExprError> {
    let exponential = Expr::function(Function::Exp, vec![Expr::from(coordinate())])?;
    Ok(exponential - Expr::one())
}

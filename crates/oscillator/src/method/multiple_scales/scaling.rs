//! The small terms of a force and their orders: the force as terms of an expansion.
//!
//! In: an equation and the small parameter asked for. Out: a `Scaling`. A parameter whose vanishing
//! leaves the linear oscillator marks the orders; several that have to vanish together count as
//! equally small; otherwise the amplitude marks them, and a linear damping counts as the power at
//! which the nonlinear terms change the frequency first: its square for quadratic and cubic terms,
//! its fourth power for `x^5` alone.

use num_traits::One;

use super::super::joint_expansion::expand_jointly;
use super::super::lindstedt_poincare::may_balance;
use super::super::{Options, Reason, Refusal, secular};
use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, Rational};
use crate::expr::{Expr, ExprError};
use crate::oscillator::{Oscillator, OscillatorError, Parts, PerturbedForce, SmallParameter, Term};
use crate::solution::note::Truncation;
use crate::solution::{AmplitudeConvention, Definition, Method, Note};
use crate::symbol::{Symbol, fresh};

/// A force with its orders.
pub(in crate::method) struct Scaling {
    pub(in crate::method) force: PerturbedForce,
    /// The bookkeeping parameter; `None` if it is the amplitude.
    pub(in crate::method) marker: Option<Symbol>,
    /// The value of the bookkeeping parameter in the answer, if the equation does not have it.
    pub(in crate::method) marks: Option<Rational>,
    /// The small parameter of the answer.
    pub(in crate::method) small: Symbol,
    /// Parameters that are small together with it.
    pub(in crate::method) small_with: Vec<Symbol>,
    /// The value of a small parameter that the equation does not have.
    pub(in crate::method) bookkeeping: Option<Definition>,
    /// A linear damping that counts as a [power](Self::small_order) of the amplitude.
    pub(in crate::method) damping: Option<Expr>,
    /// The order at which detuning, damping and a small drive enter: that at which the amplitude
    /// changes the frequency first.
    pub(in crate::method) small_order: usize,
    pub(in crate::method) order: u32,
}

impl Scaling {
    /// A polynomial with the value of the marker in its place, if the equation does not contain the
    /// marker.
    pub(super) fn unmarked(&self, polynomial: &Polynomial, marker: Symbol) -> Polynomial {
        let value = match (&self.marks, self.marker) {
            (Some(value), _) => value.clone(),
            (None, None) => Rational::one(),
            (None, Some(_)) => return polynomial.clone(),
        };
        let mut result = num_traits::Zero::zero();
        for (monomial, number) in polynomial.terms() {
            let power = value.pow(monomial.exponent(marker));
            Polynomial::add_term(&mut result, monomial.without(marker), number * power);
        }
        result
    }

    /// Returns the scaling with the small parameter, or the number, in the coefficients and a
    /// bookkeeping parameter that is one: needed if a small quantity such as the detuning does not
    /// contain the parameter. An expansion in the amplitude stays as it is.
    pub(super) fn spelt_out(mut self, taken: &[Symbol]) -> Self {
        let (Some(marker), None) = (self.marker, &self.marks) else {
            return self;
        };
        let factor =
            match self.bookkeeping.as_ref().and_then(|definition| definition.meaning.as_number()) {
                Some(number) => Polynomial::constant(number.clone()),
                None => Polynomial::symbol(marker),
            };
        for term in &mut self.force.terms {
            for _ in 0..term.order {
                term.coefficient = term.coefficient.product(&factor);
            }
        }
        self.marker = Some(fresh("delta", &[taken, &[marker]].concat()));
        self.marks = Some(Rational::one());
        self
    }

    /// Whether the order is below that at which detuning, damping and the nonlinear terms balance.
    pub(super) fn is_below_balance(&self) -> bool {
        (self.order as usize) < self.small_order
    }

    /// The note of the truncation.
    pub(super) fn cut_note(&self) -> Note {
        let together = self.small_with.iter().copied();
        let bookkeeping = self.bookkeeping.as_ref().map(|definition| definition.meaning.clone());
        // The marker itself is the small parameter if no parameter of the equation is.
        let marker = || self.marks.clone().filter(|_| self.marker == Some(self.small));
        Note::Cut(Truncation::Truncated {
            small: std::iter::once(self.small).chain(together).collect(),
            order: self.order,
            marks: bookkeeping.or_else(|| marker().map(Expr::number)),
        })
    }
}

/// The force of a free motion with its orders; defaults and highest orders are those in a parameter
/// and in the amplitude.
///
/// # Errors
/// A term that is not small or no polynomial, by name; an order above the highest.
pub(super) fn scaling(
    oscillator: &Oscillator,
    parts: &Parts,
    options: &Options,
    default: [u32; 2],
    highest: [u32; 2],
) -> Result<Scaling, Refusal> {
    let small = oscillator.small_parameter(options.small.as_deref())?;
    let mut refused = None;
    if let SmallParameter::Parameter(name) = small {
        let order = order_of(options, default[0], highest[0])?;
        match oscillator.expand(small, order) {
            Ok(force) => {
                within_reach(&force, order)?;
                return Ok(Scaling {
                    force,
                    marker: Some(name),
                    marks: None,
                    small: name,
                    small_with: vec![],
                    bookkeeping: None,
                    damping: None,
                    small_order: 1,
                    order,
                });
            }
            Err(OscillatorError::NotSmall { .. }) if !parts.damping.is_zero() => {}
            // The name `eps` alone does not decide: a force that is not a polynomial may have a
            // series for small motions.
            Err(error @ OscillatorError::NotPolynomial(_)) if options.small.is_none() => {
                refused = Some(error)
            }
            Err(error) => return Err(error.into()),
        }
    }
    if let Some(found) = jointly_small(oscillator, parts, options, small, [default[0], highest[0]])?
    {
        return Ok(found);
    }
    let times = order_of_shift(oscillator) / SHIFT_OF_A_CUBE;
    let order = order_of(options, times * default[1], times * highest[1])?;
    match (in_amplitude(oscillator, order), refused) {
        (Err(_), Some(error)) => Err(error.into()),
        // At a lower order a damped motion would not lose energy.
        (Ok(found), _) if found.damping.is_some() && found.is_below_balance() => {
            let lowest = SHIFT_OF_A_CUBE;
            Err(Reason::BelowBalance(lowest).to(Method::MultipleScales))
        }
        (found, _) => found,
    }
}

/// The expansion in parameters that are small together, or in one that marks all terms but the
/// linear one of an equation that may have a limit cycle; `None` if the amplitude is to be the
/// small parameter.
fn jointly_small(
    oscillator: &Oscillator,
    parts: &Parts,
    options: &Options,
    small: SmallParameter,
    [default, highest]: [u32; 2],
) -> Result<Option<Scaling>, Refusal> {
    let in_amplitude = options.small.is_some() && small == SmallParameter::Amplitude;
    if parts.damping.is_zero() || in_amplitude {
        return Ok(None);
    }
    let Some(probe) = expand_jointly(oscillator, parts, small, 1) else {
        return Ok(None);
    };
    if probe.parameters.is_empty() && !may_balance(&probe.force) {
        return Ok(None);
    }
    let order = order_of(options, default, highest)?;
    let Some(joint) = expand_jointly(oscillator, parts, small, order) else {
        return Ok(None);
    };
    within_reach(&joint.force, order)?;
    let mut parameters = joint.parameters.into_iter();
    let first = parameters.next();
    let value = joint.value.unwrap_or_else(One::one);
    Ok(Some(Scaling {
        force: joint.force,
        marker: Some(joint.delta),
        marks: first.is_some().then(|| value.clone()),
        bookkeeping: first
            .is_none()
            .then(|| Definition { symbol: joint.delta, meaning: Expr::number(value) }),
        small: first.unwrap_or(joint.delta),
        small_with: parameters.collect(),
        damping: None,
        small_order: 1,
        order,
    }))
}

/// The expansion in the amplitude, a linear damping taken out and put back as its square.
fn in_amplitude(oscillator: &Oscillator, order: u32) -> Result<Scaling, Refusal> {
    let small_order = order_of_balance(oscillator, order) as usize;
    let velocity = oscillator.velocity();
    let (rest, damping) = without_linear_damping(oscillator)?;
    let mut force = rest.expand(SmallParameter::Amplitude, order)?;
    if !damping.is_zero() {
        let not_polynomial =
            || Refusal::from(OscillatorError::NotPolynomial(damping.clone().into()));
        let coefficient = damping.to_polynomial(&mut |_| None)?.ok_or_else(not_polynomial)?;
        let over = Monomial::power_of(velocity, -1);
        force.terms.push(Term {
            order: small_order,
            position: 0,
            velocity: 1,
            coefficient: coefficient.times_monomial(&over),
        });
    }
    within_reach(&force, order)?;
    Ok(Scaling {
        force,
        marker: None,
        marks: None,
        small: AmplitudeConvention::FirstHarmonic.symbol(),
        small_with: vec![],
        bookkeeping: None,
        damping: (!damping.is_zero()).then_some(damping),
        small_order,
        order,
    })
}

/// The order in the amplitude at which cubic and quadratic terms change the frequency.
const SHIFT_OF_A_CUBE: u32 = 2;

/// The order in the amplitude as which damping, detuning and a small drive count: that at which the
/// nonlinear terms change the frequency first, but if `order` is lower, and so contains none of
/// these terms, `order` itself.
pub fn order_of_balance(oscillator: &Oscillator, order: u32) -> u32 {
    order_of_shift(oscillator).min(order.max(SHIFT_OF_A_CUBE))
}

/// The order in the amplitude at which the terms of a force change the frequency first: `n - 1` of
/// an odd power `n`, `2 (n - 1)` of an even one; that of a cubic force if no such term is known.
fn order_of_shift(oscillator: &Oscillator) -> u32 {
    const HIGHEST: u32 = 8;
    let Ok((oscillator, _)) = without_linear_damping(oscillator) else {
        return SHIFT_OF_A_CUBE;
    };
    let shift = |degree: u32| match degree % 2 {
        1 => degree - 1,
        _ => 2 * (degree - 1),
    };
    for order in (SHIFT_OF_A_CUBE..=HIGHEST).step_by(2) {
        let Ok(force) = oscillator.expand(SmallParameter::Amplitude, order) else {
            break;
        };
        let degrees = force.terms.iter().map(|term| term.position + term.velocity);
        match degrees.filter(|degree| *degree > 1).map(shift).min() {
            Some(lowest) if lowest <= order => return lowest,
            _ => {}
        }
    }
    SHIFT_OF_A_CUBE
}

/// Whether the force has quadratic terms about `x = 0`: their effect on the frequency is as large
/// as that of cubic ones, and appears one order later if both count as equally small.
pub(in crate::method) fn has_quadratic_terms(oscillator: &Oscillator) -> bool {
    let expanded = in_amplitude(oscillator, 1);
    expanded.is_ok_and(|scaling| scaling.force.terms.iter().any(|term| term.order == 1))
}

/// Whether a quadratic term dissipates or feeds energy about `x = 0`, as `x*x'` does: with other
/// quadratic terms it acts on the amplitude as a cubic damping does.
pub(in crate::method) fn has_quadratic_damping(oscillator: &Oscillator) -> bool {
    let expanded = in_amplitude(oscillator, 1);
    let drains = |term: &Term| term.order == 1 && term.velocity % 2 == 1;
    expanded.is_ok_and(|scaling| scaling.force.terms.iter().any(drains))
}

/// Whether all damping is proportional to the velocity.
pub(in crate::method) fn has_linear_damping(oscillator: &Oscillator, parts: &Parts) -> bool {
    let is_all =
        |linear: Expr| (&linear - &parts.damping).expand().is_ok_and(|rest| rest.is_zero());
    linear_damping(&parts.damping, oscillator).is_ok_and(is_all)
}

/// The linear part at rest of the terms that damp in proportion to the velocity: `4*nu*x'` for
/// `4*nu*x'/(1 + x)^2`. A steep function of the velocity, as for dry friction, is no small damping.
fn linear_damping(damping: &Expr, oscillator: &Oscillator) -> Result<Expr, ExprError> {
    let velocity = Expr::from(oscillator.velocity());
    let mut linear = Vec::new();
    for term in damping.terms() {
        let factor = Expr::divide(term, &velocity)?;
        let proportional = !factor.contains(oscillator.velocity());
        // A term without a value at rest stays, and the expansion refuses it by name.
        if let (true, Ok(at_rest)) =
            (proportional, factor.substitute(oscillator.coordinate, &Expr::zero()))
        {
            linear.push(at_rest * velocity.clone());
        }
    }
    Expr::sum(linear).expand()
}

/// The equation without the damping that is linear in the velocity at rest, and that damping.
fn without_linear_damping(oscillator: &Oscillator) -> Result<(Oscillator, Expr), Refusal> {
    let damping = linear_damping(&oscillator.parts()?.damping, oscillator)?;
    let mut rest = oscillator.clone();
    rest.force = (&oscillator.force - &damping).expand()?;
    Ok((rest, damping))
}

fn order_of(options: &Options, default: u32, highest: u32) -> Result<u32, Refusal> {
    match options.order {
        Some(asked) if asked > highest => {
            Err(Reason::HighestOrder(highest).to(Method::MultipleScales))
        }
        Some(asked) => Ok(asked),
        None => Ok(default),
    }
}

/// An error if powers are so high that an expansion would take too long.
fn within_reach(force: &PerturbedForce, order: u32) -> Result<(), secular::SecularError> {
    let terms = force.terms.iter();
    bounded(terms.map(|term| term.position + term.velocity), order)
}

/// Like [`within_reach`], for the orders and powers of the terms alone.
pub(in crate::method) fn bounded(
    powers: impl Iterator<Item = u32>,
    order: u32,
) -> Result<(), secular::SecularError> {
    /// Every harmonic of a power has coefficients in `B` and its conjugate, which grow with the
    /// order.
    const MOST: u32 = 200;
    let degree = powers.max().unwrap_or(0);
    match degree.saturating_mul(order.max(1).saturating_pow(2)) > MOST && degree > 9 {
        true => Err(secular::SecularError::TooManyHarmonics {
            degree,
            harmonics: (degree as usize).saturating_mul(order as usize),
        }),
        false => Ok(()),
    }
}

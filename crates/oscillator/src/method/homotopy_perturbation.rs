//! Homotopy perturbation: the whole nonlinearity at the first power of a bookkeeping parameter.
//!
//! References: J.-H. He, *Homotopy perturbation technique*, Comput. Methods Appl. Mech. Eng. 178
//! (1999) 257-262; the paper's equation (12) is the first order of this method on its equation
//! (11).
//!
//! ```text
//! x'' + omega0^2 x + p N(x) = 0,               x = x_0 + p x_1 + ...,   x_0 = A cos(omega t)
//! omega0^2 = omega^2 + p a_1 + p^2 a_2 + ...,   x_k(0) = x_k'(0) = 0
//! omega^2 (x_n'' + x_n) = - sum_(i=1..n) a_i x_(n-i) - N_(n-1),   no secular term fixes a_n
//! ```
//!
//! At p = 1 the second line is an equation for omega^2, exact in its coefficients: explicit at
//! order one, a square root at order two, implicit above. In units of omega^2 this is
//! [`secular::expand`](super::secular::expand) with the corrections before `y` instead of `y''`. A
//! force that is not a polynomial enters as its Taylor polynomial of degree `2 n + 1`. Inertia that
//! depends on the position stands in `N`, with `x' = omega x_theta`; the relation then is quadratic
//! at order one.
//!
//! Cost: that of [`secular::expand`](super::secular::expand).
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let cubic = Oscillator::parse("x'' + x - x^3/6 = 0")?;
//! let options = Options { method: Some(Method::HomotopyPerturbation), order: Some(1), ..Options::default() };
//! assert_eq!(solve(&cubic, &options)?.law.frequency_squared().unwrap().to_string(), "1 - A^2/8");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use num_traits::{One, Zero};

use super::expansion::expand_exactly;
use super::inertia::VariableMass;
use super::one_term::conservative_force;
use super::secular::{AmplitudeKind, Detuning, ExpansionScope, Scheme};
use super::{Options, Reason, Refusal};
use crate::derivation::DerivationLine;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{POLYNOMIALS, Polynomial, Rational};
use crate::expr::{Expr, ExprError};
use crate::interrupt::Supervision;
use crate::oscillator::{Oscillator, SmallParameter, Term};
use crate::solution::note::Truncation;
use crate::solution::{AmplitudeConvention, ClosedForm, Law, Method, Note, Root, Solution};
use crate::symbol::{Symbol, fresh};

/// Derives the relation between frequency and amplitude, and the motion, to an order in the
/// bookkeeping parameter.
///
/// # Errors
/// Damping, forcing, velocities other than those of inertia, or a force that cannot be expanded,
/// each by name.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    with_stiffness(oscillator, options, true)
}

/// Does the work of [`solve`] for a force whose linear part may be missing, `0 = omega^2 + p a_1 +
/// ...`, as parameter expansion allows.
pub(super) fn solve_without_linear_part(
    oscillator: &Oscillator,
    options: &Options,
) -> Result<Solution, Refusal> {
    with_stiffness(oscillator, options, false)
}

fn with_stiffness(
    oscillator: &Oscillator,
    options: &Options,
    needed: bool,
) -> Result<Solution, Refusal> {
    const METHOD: Method = Method::HomotopyPerturbation;
    let moving = VariableMass::from_oscillator(oscillator)?.is_some();
    if !moving {
        conservative_force(oscillator, options, METHOD)?;
    } else if options.amplitude == Some(AmplitudeConvention::FirstHarmonic) {
        return Err(Reason::Convention.to(METHOD));
    }
    let order = options.order.unwrap_or(2);
    let degree = match oscillator.polynomial_degree()? {
        // The degree counts velocities as well.
        Some(degree) if options.taylor.is_none() => degree + if moving { 2 } else { 0 },
        _ => options.taylor.unwrap_or(2 * order + 1),
    };
    let force = oscillator
        .expand_with_any_stiffness(SmallParameter::Amplitude, degree.saturating_sub(1))?;
    // For motions through an unstable equilibrium that was asked for, omega0^2 is negative; the
    // recursion holds for either sign.
    let passed = oscillator.about.is_some() && !force.linear.is_zero();
    let force = match needed && !passed {
        true => oscillator.expand(SmallParameter::Amplitude, degree.saturating_sub(1))?,
        false => force,
    };
    let (amplitude, omega) = (Symbol::new("A"), Symbol::new("omega"));
    let terms = embedded(&force.terms, amplitude, omega);
    let scheme = Scheme {
        normalisation: AmplitudeConvention::Initial,
        amplitude: AmplitudeKind::Free,
        detuning: Detuning::Displacement,
    };
    let series = expand_exactly(
        &terms,
        order,
        &scheme,
        None,
        None,
        (&oscillator.names(), ExpansionScope::Motion),
        Supervision::default(),
    )?;

    let explicit = explicit_terms(&series.frequency_squared, &force.linear, omega);
    let relation = relation(&explicit, omega);
    let root = match explicit.exponent_range(omega).is_none_or(|range| range == (0, 0)) {
        true => Some(Root::Polynomial(explicit)),
        false => root_in_closed_form(&relation, omega)?
            .map(|value| Root::Closed(ClosedForm { squared: true, value })),
    };
    let small = match oscillator.small_parameter(options.small.as_deref()) {
        Ok(SmallParameter::Parameter(name)) => name,
        _ => amplitude,
    };
    let mut validity = vec![Note::Cut(Truncation::TruncatedRelation {
        bookkeeping: fresh("p", &oscillator.names()),
        order,
        linear_frequency: Some(oscillator.linear_frequency_name(&force.linear)),
    })];
    if oscillator.polynomial_degree()?.is_none() {
        validity.push(Note::TaylorPolynomial { degree });
    }
    Ok(Solution {
        equation: oscillator.equation(),
        method: Method::HomotopyPerturbation,
        order,
        degrees: None,
        small_parameter: small,
        amplitude: AmplitudeConvention::Initial,
        parameters: oscillator.parameters.clone(),
        definitions: force.definitions,
        equilibrium: Expr::zero(),
        law: Law::Relation { relation, root },
        displacement: series
            .displacement
            .map(POLYNOMIALS, |coefficient, _| coefficient.product(&Polynomial::symbol(amplitude))),
        limit_cycle: None,
        modulation: None,
        response: None,
        numerical: false,
        closed_motion: None,
        convergence: None,
        validity,
        steps: series.steps,
        derivation: vec![DerivationLine::equation(
            Expr::from(oscillator.linear_frequency_name(&force.linear)).integer_power(2)?,
            &force.linear,
        )],
    })
}

/// The terms of the force under the embedding: every term but the linear one has the factor `p`, in
/// units of `omega^2`.
fn embedded(terms: &[Term], amplitude: Symbol, omega: Symbol) -> Vec<Term> {
    let term = |term: &Term| {
        let (position, velocity) = (term.position as i32, term.velocity as i32);
        let unit = Monomial::power_of(amplitude, position + velocity - 1);
        let unit = unit.product(&Monomial::power_of(omega, velocity - 2));
        Term { order: 1, coefficient: term.coefficient.times_monomial(&unit), ..term.clone() }
    };
    terms.iter().map(term).collect()
}

/// `omega0^2 + omega^2 (W_1 + W_2 + ...)`, which is `omega^2`: `series`, in units of `omega^2`, is
/// `1 + W_1 + W_2 + ...`, and `omega0^2 = omega^2 (1 - W_1 - ...)`.
fn explicit_terms(series: &Polynomial, linear: &Polynomial, omega: Symbol) -> Polynomial {
    let mut corrections = series.clone();
    corrections.accumulate(&Polynomial::constant(-Rational::one()));
    let mut explicit =
        corrections.product(&Polynomial::term(Monomial::power_of(omega, 2), Rational::one()));
    explicit.accumulate(linear);
    explicit
}

/// `omega^2 - explicit = 0` in whole powers of `omega`: denominators are multiplied out.
fn relation(explicit: &Polynomial, omega: Symbol) -> Polynomial {
    let mut relation = explicit.clone();
    relation.negate();
    relation.accumulate(&Polynomial::term(Monomial::power_of(omega, 2), Rational::one()));
    let lowest = relation.exponent_range(omega).map_or(0, |range| range.0.min(0));
    relation.times_monomial(&Monomial::power_of(omega, -lowest))
}

/// The root of a relation that is linear in `omega^2`, or the upper one where it is quadratic, as
/// an expression; `None` if it is of higher degree.
fn root_in_closed_form(relation: &Polynomial, omega: Symbol) -> Result<Option<Expr>, ExprError> {
    let coefficient = |power: i32| {
        let mut result = Polynomial::zero();
        for (monomial, number) in
            relation.terms().filter(|(monomial, _)| monomial.exponent(omega) == power)
        {
            result.add_term(monomial.without(omega), number.clone());
        }
        result
    };
    let (a, mut b, c) = (coefficient(4), coefficient(2), coefficient(0));
    b.negate();
    match relation.exponent_range(omega) {
        // b z = c
        Some((0, 2)) => return Expr::divide(&Expr::from(&c), &Expr::from(&b)).map(Some),
        Some((0, 4)) => {}
        _ => return Ok(None),
    }
    // a z^2 - b z + c = 0, a = 1 at rest
    let mut discriminant = b.product(&b);
    discriminant.accumulate(&a.product(&c).product(&Polynomial::constant(ratio(-4, 1))));
    let root = Expr::from(&discriminant).sqrt()?;
    let twice = (Expr::from(2) * Expr::from(&a)).expand()?;
    Ok(Some(Expr::divide(&(&Expr::from(&b) + &root), &twice)?))
}

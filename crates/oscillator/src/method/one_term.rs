//! The motion of one term, `x = A cos(theta)`: what the classical frequency formulas share.
//!
//! References: R. E. Mickens, *Truly Nonlinear Oscillations*, World Scientific 2010, chapter 3; N.
//! Krylov, N. Bogoliubov, *Introduction to Non-Linear Mechanics*, Princeton 1943 (equivalent
//! linearisation).
//!
//! ```text
//! x'' + f(x) = 0,   x = A cos(theta),   theta = omega t
//! f(A cos theta) = c_0/2 + c_1 cos theta + c_2 cos 2 theta + ...
//! omega^2 = c_1/A = (2/(pi A)) int_0^pi f(A cos theta) cos(theta) dtheta
//! ```
//!
//! Even terms of the force contribute nothing to `c_1`: the drift that they cause is left out, and
//! a note of the answer says so.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::{Options, Reason, Refusal, Refuser, first_term};
use crate::conservative::force::CentredForce;
use crate::conservative::is_odd;
use crate::conservative::parity::twice_even_part;
use crate::conservative::projection::cosine_coefficient;
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials};
use crate::expr::{CompiledFunction, Expr, ExprError};
use crate::numeric::ode::quadrature::{QuadratureError, integrate_piecewise};
use crate::oscillator::{Oscillator, SmallParameter};
use crate::series::FourierSeries;
use crate::solution::{
    AmplitudeConvention, ClosedForm, Law, Method, Note, Solution, note::ExactFirstStep,
};
use crate::symbol::Symbol;

/// The force of an oscillator that is conservative: no damping, forcing or velocities.
///
/// # Errors
/// The term in the way, by name; or an amplitude of the first harmonic, which these methods do not
/// use.
pub(super) fn conservative_force(
    oscillator: &Oscillator,
    options: &Options,
    method: Method,
) -> Result<Expr, Refusal> {
    let parts = oscillator.parts()?;
    if !parts.forcing.is_zero() {
        return Err(Reason::Forcing.to(method).about(first_term(&parts.forcing)));
    }
    match parts.damping.terms() {
        [zero] if zero.is_zero() => {}
        [only] => return Err(Refusal::damping(only, Refuser::Method(method))),
        // Terms that feed energy for some motions and drain it for others.
        _ => {
            return Err(Reason::Velocity.to(method).about(first_term(&parts.damping)));
        }
    }
    if !parts.inertia.is_zero() {
        return Err(Reason::Velocity.to(method).about(first_term(&parts.inertia)));
    }
    if options.amplitude == Some(AmplitudeConvention::FirstHarmonic) {
        return Err(Reason::Convention.to(method));
    }
    Ok(oscillator.force.clone())
}

/// Refuses a force that is not odd, by its first even term.
pub(super) fn require_odd(
    oscillator: &Oscillator,
    force: &Expr,
    method: Method,
) -> Result<(), Refusal> {
    if is_odd(force, oscillator.coordinate)? {
        return Ok(());
    }
    let term = even_part(oscillator, force)?;
    let term = first_term(&term);
    Err(Reason::NotOdd.to(method).about(term))
}

/// Refuses any order but the first.
pub(super) fn first_order_only(options: &Options, method: Method) -> Result<(), Refusal> {
    match options.order {
        None | Some(1) => Ok(()),
        Some(_) => Err(Reason::HighestOrder(1).to(method)),
    }
}

/// The terms of a force that keep their sign when the coordinate changes its own.
pub(super) fn even_part(oscillator: &Oscillator, force: &Expr) -> Result<Expr, Refusal> {
    let sum = twice_even_part(force, oscillator.coordinate)?;
    Ok(Expr::divide(&sum, &Expr::from(2))?)
}

/// An answer with the one-term motion and no law yet.
pub(super) fn unsolved(
    oscillator: &Oscillator,
    options: &Options,
    method: Method,
    order: u32,
) -> Solution {
    let amplitude = Symbol::new("A");
    let small = match oscillator.small_parameter(options.small.as_deref()) {
        Ok(SmallParameter::Parameter(name)) => name,
        _ => amplitude,
    };
    Solution {
        equation: oscillator.equation(),
        method,
        order,
        degrees: None,
        small_parameter: small,
        amplitude: AmplitudeConvention::Initial,
        parameters: oscillator.parameters.clone(),
        definitions: vec![],
        equilibrium: Expr::zero(),
        // Every method replaces this placeholder by its own law.
        law: Law::Quadrature(vec![]),
        displacement: cosine(Polynomial::symbol(amplitude)),
        limit_cycle: None,
        modulation: None,
        response: None,
        numerical: false,
        closed_motion: None,
        convergence: None,
        validity: vec![],
        steps: vec![],
        derivation: vec![],
    }
}

/// `coefficient * cos(theta)`.
pub(super) fn cosine(coefficient: Polynomial) -> FourierSeries<Polynomials> {
    FourierSeries::cos(POLYNOMIALS, 1).product(&FourierSeries::constant(POLYNOMIALS, coefficient))
}

/// Sets the law for omega^2 of an answer: a polynomial if it is one, otherwise a closed form.
pub(super) fn set_law(solution: &mut Solution, law: &Expr) -> Result<(), Refusal> {
    solution.law = match law.to_polynomial(&mut |_| None)? {
        Some(polynomial) => Law::squared(polynomial),
        None => Law::Closed(ClosedForm { squared: true, value: law.factored() }),
    };
    Ok(())
}

/// `c_1/A` in closed form, where it has one.
pub(super) fn shared_integral(oscillator: &Oscillator, force: &Expr) -> Option<Expr> {
    let amplitude = Expr::symbol("A");
    let first = cosine_coefficient(force, oscillator.coordinate, &amplitude, 1)?;
    Some(Expr::divide(&first, &amplitude).ok()?.expand().ok()?.factored())
}

/// The answer of the methods whose law is the shared integral.
///
/// # Errors
/// As [`conservative_force`]; an order above the first.
pub(super) fn solve_by_integral(
    oscillator: &Oscillator,
    options: &Options,
    method: Method,
) -> Result<Solution, Refusal> {
    let force = conservative_force(oscillator, options, method)?;
    let mut solution = unsolved(oscillator, options, method, 1);
    match shared_integral(oscillator, &force) {
        Some(law) => set_law(&mut solution, &law)?,
        None => {
            let squared = Expr::symbol("omega").integer_power(2)?;
            let integral = first_projection(oscillator, &force)?;
            solution.law = Law::Quadrature(vec![DerivationLine::equation(squared, integral)]);
        }
    }
    solution.validity.push(Note::FirstStep(ExactFirstStep::TermOfForce));
    note_even_part(&mut solution, oscillator, &force)?;
    solution.derivation =
        vec![DerivationLine::equation(oscillator.coordinate, solution.displacement.clone())];
    let law = integral_law(oscillator, &force, &solution)?;
    solution.derivation.extend(law);
    Ok(solution)
}

/// Says which part of the force a motion of one term leaves out.
pub(super) fn note_even_part(
    solution: &mut Solution,
    oscillator: &Oscillator,
    force: &Expr,
) -> Result<(), Refusal> {
    let even = even_part(oscillator, force)?;
    if !even.is_zero() {
        solution.validity.push(Note::EvenPartLeftOut(even));
    }
    Ok(())
}

/// Moves the note of the even part of the force behind the notes that were added since.
pub(super) fn note_even_part_last(solution: &mut Solution) {
    // False sorts before true, and the others keep their order.
    solution.validity.sort_by_key(|note| matches!(note, Note::EvenPartLeftOut(_)));
}

/// `(2/(pi A)) int_0^pi f(A cos theta) cos(theta) dtheta`, written out.
pub(super) fn first_projection(
    oscillator: &Oscillator,
    force: &Expr,
) -> Result<DerivationFormula, ExprError> {
    let (amplitude, cosine) = (Expr::symbol("A"), Expr::from(oscillator.phase()).cos()?);
    let along = force.substitute(oscillator.coordinate, &(&amplitude * &cosine))?;
    Ok(DerivationFormula::Integral {
        factor: Expr::divide(&Expr::from(2), &(Expr::pi() * amplitude))?,
        from: Expr::zero(),
        to: Expr::pi(),
        integrand: Box::new((along * cosine).into()),
        variable: oscillator.phase(),
    })
}

/// The condition that the `cos(theta)` of the force balances that of the acceleration, and the law
/// that follows.
pub(super) fn integral_law(
    oscillator: &Oscillator,
    force: &Expr,
    solution: &Solution,
) -> Result<Vec<DerivationLine>, Refusal> {
    let squared = Expr::symbol("omega").integer_power(2)?;
    let mut equal = vec![squared.into(), first_projection(oscillator, force)?];
    equal.extend(law_of(solution).map(DerivationFormula::from));
    Ok(vec![DerivationLine::equal(equal).because("no cos(θ) remains in the equation")])
}

/// omega^2 of an answer that has it as a polynomial or in closed form.
pub(super) fn law_of(solution: &Solution) -> Option<Expr> {
    let polynomial = solution.law.frequency_squared().map(Expr::from);
    polynomial.or_else(|| {
        let form = solution.law.closed_form().filter(|form| form.squared)?;
        Some(form.value.clone())
    })
}

/// `c_1/A` of a force by quadrature, which is omega^2 for the methods whose law is the shared
/// integral, with a bound of its relative error.
pub(super) fn first_projection_over_amplitude(
    force: &CentredForce,
    amplitude: f64,
) -> Option<(f64, f64)> {
    let (projection, error) = coefficient(force, amplitude, 1);
    Some((projection / amplitude, error / projection.abs()))
}

/// `c_k` of a force by quadrature, and the change at the last doubling of the points, which bounds
/// its error: the midpoint rule in theta, which converges geometrically for smooth forces and like
/// a power at corners.
pub(crate) fn coefficient_by_quadrature(
    force: &dyn Fn(f64) -> f64,
    amplitude: f64,
    k: usize,
) -> (f64, f64) {
    const FEWEST: usize = 64;
    const MOST: usize = 1 << 14;
    // The sum, and the size of what is added up: rounding leaves an error of that size times
    // epsilon.
    let with_points = |points: usize| {
        let value = |i: usize| {
            let theta = PI * (i as f64 + 0.5) / points as f64;
            force(amplitude * theta.cos()) * (k as f64 * theta).cos()
        };
        let sums = (0..points)
            .map(value)
            .fold((0.0, 0.0), |(sum, size), value| (sum + value, size + value.abs()));
        (2.0 / points as f64 * sums.0, 2.0 / points as f64 * sums.1)
    };
    let (mut value, mut points) = (with_points(FEWEST).0, 2 * FEWEST);
    loop {
        let (finer, size) = with_points(points);
        let change = (finer - value).abs();
        value = finer;
        points *= 2;
        if change <= 1e-15 * size || points > MOST {
            return (value, change);
        }
    }
}

/// `c_k` of a force about its equilibrium, and a bound of its error: by adaptive Gauss quadrature
/// between corners and narrow features, if the force has any.
pub(crate) fn coefficient(force: &CentredForce, amplitude: f64, k: usize) -> (f64, f64) {
    const TOLERANCE: f64 = 1e-14;
    let cuts = force.cuts(-amplitude.abs(), amplitude.abs());
    if cuts.is_empty() {
        return coefficient_by_quadrature(&|y| force.value(y), amplitude, k);
    }
    let mut angles: Vec<f64> =
        cuts.iter().map(|cut| (cut / amplitude).clamp(-1.0, 1.0).acos()).collect();
    angles.extend([0.0, PI]);
    angles.sort_by(f64::total_cmp);
    let integrand = |theta: f64| force.value(amplitude * theta.cos()) * (k as f64 * theta).cos();
    let sum = match integrate_piecewise(integrand, &angles, TOLERANCE) {
        Ok(found) => found,
        Err(QuadratureError::NotConverged { value, error_estimate, .. }) => (value, error_estimate),
        Err(_) => (f64::NAN, f64::NAN),
    };
    (sum.0 * 2.0 / PI, sum.1 * 2.0 / PI)
}

/// The force at given numbers, as a function of the position.
pub(crate) fn compiled(
    oscillator: &Oscillator,
    force: &Expr,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<impl Fn(f64) -> f64 + use<>> {
    let names: Vec<Symbol> =
        std::iter::once(oscillator.coordinate).chain(numbers.keys().copied()).collect();
    let function = CompiledFunction::new(force, &names).ok()?;
    let arguments: Vec<f64> = std::iter::once(0.0).chain(numbers.values().copied()).collect();
    // One row of arguments for all calls: only its first entry, the position, changes.
    let arguments = std::cell::RefCell::new(arguments);
    Some(move |x: f64| {
        let mut arguments = arguments.borrow_mut();
        arguments[0] = x;
        function.call(&arguments)
    })
}

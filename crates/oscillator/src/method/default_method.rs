//! The choice of a method if none is asked for.
//!
//! ```text
//! linear, free, damped or driven         exact, where no order, resonance or small parameter is asked for
//! time occurs                            multiple scales; averaging where the force has no expansion
//! energy is drained or fed               Lindstedt-Poincare on a limit cycle, else averaging; multiple scales in powers of the
//!                                        amplitude where quadratic terms stand beside a linear damping, or where averaging knows
//!                                        no closed form for the first harmonic
//! conservative                           Lindstedt-Poincare
//! conservative, without an expansion     an order asked for: so many harmonics balanced;
//!                                        exact, where its law is closed; Lindstedt-Poincare in the amplitude, where a letter alone
//!                                        stood in the way; Hamiltonian, where its law is closed and the force odd; else exact, by
//!                                        quadrature; the same through an unstable equilibrium that is asked for
//! ```
//!
//! A formula of one term leaves out the drift that an even force causes, and is not used then. The
//! answer says when another method takes the place of the usual one.

use super::linear::{Linear, is_free_and_linear};
use super::multiple_scales::scaling::{
    has_linear_damping, has_quadratic_damping, has_quadratic_terms,
};
use super::{Options, Reason, Refusal, solve_by};
use crate::equilibrium::centred;
use crate::oscillator::{Oscillator, OscillatorError, Parts, SmallParameter};
use crate::solution::note::Truncation;
use crate::solution::{AmplitudeConvention, Law, Method, Note, Solution};
use crate::symbol::Symbol;

/// The order in the amplitude at which the frequency of a free motion changes first.
const SECOND_ORDER: u32 = 2;

/// The method that suits an equation, where none is asked for: multiple scales where something
/// drives it, else that of Lindstedt and Poincare. Where that one has no expansion to begin with,
/// [`solve`](super::solve) goes on to one that needs none.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::{Method, Oscillator, method::default_method};
///
/// let driven = Oscillator::parse("x'' + x'/10 + x + x^3 = cos(2*t)")?;
/// assert_eq!(default_method(&driven), Method::MultipleScales);
/// # Ok::<(), lindstedt::oscillator::OscillatorError>(())
/// ```
pub fn default_method(oscillator: &Oscillator) -> Method {
    match oscillator.force.contains(Symbol::new("t")) {
        true => Method::MultipleScales,
        false => Method::LindstedtPoincare,
    }
}

/// Solves by the method that suits the equation.
///
/// # Errors
/// The refusal of the usual method, where no other one takes its place.
pub(super) fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    if let Some(exact) = linear(oscillator, options) {
        return Ok(exact);
    }
    let usual = default_method(oscillator);
    let found = solve_by(usual, oscillator, options);
    let refusal = match &found {
        Err(refusal) => refusal,
        Ok(solution) if begins_wrongly(solution, oscillator) => {
            return match in_small_motions(oscillator, options) {
                Some(in_amplitude) => Ok(in_amplitude),
                None => found,
            };
        }
        Ok(_) => return found,
    };
    if usual == Method::MultipleScales {
        // A force without a series in the amplitude is averaged as it is.
        return match &refusal.reason {
            Reason::Oscillator(
                OscillatorError::NotPolynomial(_)
                | OscillatorError::Taylor(_)
                | OscillatorError::NotSmall { .. }
                | OscillatorError::NoEquilibrium(_),
            ) => solve_by(Method::Averaging, oscillator, options).or(found),
            _ => found,
        };
    }
    // Only expansions can give a certain limit cycle, or the frequency alone.
    if options.cycle.is_some() || options.frequency_alone {
        return found;
    }
    if is_of_damping(refusal, oscillator) {
        if let Some(found) = in_small_motions(oscillator, options) {
            return Ok(found);
        }
        return averaged(oscillator, options)
            .or_else(|refusal| in_powers(refusal, oscillator, options));
    }
    match without_expansion(refusal, oscillator, options) {
        Some(solution) => Ok(solution),
        None => found,
    }
}

/// The exact motion of a linear equation, free, damped or driven; `None` if the equation is another
/// one, or an expansion of the motion is asked for.
pub(super) fn linear(oscillator: &Oscillator, options: &Options) -> Option<Solution> {
    let expansion = options.method.is_some()
        || options.order.is_some()
        || options.resonance.is_some()
        || options.small.is_some()
        || options.cycle.is_some();
    let free = |centred: &Oscillator| is_free_and_linear(centred).unwrap_or(false);
    let moved = |centred: &Oscillator| {
        !options.frequency_alone && matches!(Linear::new(centred), Ok(Some(_)))
    };
    if expansion || !about_equilibrium(oscillator, |centred, _| free(centred) || moved(centred)) {
        return None;
    }
    solve_by(Method::Exact, oscillator, options).ok()
}

/// Whether an expansion in periodic motions is refused because of a term that dissipates or feeds
/// energy.
pub(super) fn is_of_damping(refusal: &Refusal, oscillator: &Oscillator) -> bool {
    let damped = || {
        let parts = oscillator.parts();
        parts.is_ok_and(|parts| !parts.damping.is_zero() && parts.forcing.is_zero())
    };
    match &refusal.reason {
        Reason::Damping { .. } | Reason::AmplitudeNotFree | Reason::NoLimitCycle(_) => damped(),
        Reason::Oscillator(
            OscillatorError::NotSmall { .. } | OscillatorError::NoEquilibrium(_),
        ) => damped(),
        Reason::Oscillator(error) => has_no_expansion(error) && damped(),
        _ => false,
    }
}

/// Whether a force has no series with a linear part about its equilibrium.
fn has_no_expansion(error: &OscillatorError) -> bool {
    matches!(
        error,
        OscillatorError::NotPolynomial(_)
            | OscillatorError::Taylor(_)
            | OscillatorError::NoRestoringForce(_)
    )
}

/// Averaging, to the order asked for or the highest that there is.
fn averaged(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    let asked = options.order.unwrap_or(1);
    let mut given = asked;
    loop {
        let options = Options { order: Some(given), ..options.clone() };
        let lower =
            match solve_by(Method::Averaging, oscillator, &options) {
                Ok(mut solution) => {
                    if given < asked {
                        solution.validity.push(Note::HighestOrderHere { asked, given });
                    }
                    return Ok(solution);
                }
                Err(Refusal { reason: Reason::HighestOrder(highest), .. }) if highest < given => {
                    highest
                }
                Err(Refusal {
                    reason: Reason::PolynomialOnly | Reason::FirstOrderOfPower, ..
                }) if given > 1 => 1,
                Err(refusal) => return Err(refusal),
            };
        given = lower;
    }
}

/// Whether the terms from which a limit cycle begins are not the leading ones: no parameter makes
/// all but the linear terms small, and quadratic terms that damp act on the amplitude as cubic ones
/// do.
fn begins_wrongly(solution: &Solution, oscillator: &Oscillator) -> bool {
    let marked =
        |note: &Note| matches!(note, Note::Cut(Truncation::Truncated { marks: Some(_), .. }));
    solution.limit_cycle.is_some()
        && solution.validity.iter().any(marked)
        && about_equilibrium(oscillator, |centred, _| has_quadratic_damping(centred))
}

/// Whether a property holds for the oscillator about its equilibrium.
fn about_equilibrium(oscillator: &Oscillator, is_so: impl Fn(&Oscillator, &Parts) -> bool) -> bool {
    let Ok(centred) = centred(oscillator, None) else {
        return false;
    };
    let parts = centred.oscillator.parts();
    parts.is_ok_and(|parts| is_so(&centred.oscillator, &parts))
}

/// Whether the motions are those over the wells on both sides of an unstable equilibrium.
fn swings_over_a_hilltop(oscillator: &Oscillator) -> bool {
    centred(oscillator, None).is_ok_and(|centred| centred.cross_well.is_some())
}

/// Slow equations in powers of the amplitude, if the amplitude is the small parameter asked for, or
/// if the first order of averaging leaves out quadratic terms.
fn in_small_motions(oscillator: &Oscillator, options: &Options) -> Option<Solution> {
    let small = oscillator.small_parameter(options.small.as_deref());
    let asked = options.small.is_some() && matches!(small, Ok(SmallParameter::Amplitude));
    let quadratic = |centred: &Oscillator, parts: &Parts| match has_linear_damping(centred, parts) {
        true => has_quadratic_terms(centred),
        false => has_quadratic_damping(centred),
    };
    let told = || options.cycle.is_some() || options.say_what_is_small(oscillator);
    if !asked && (told() || !about_equilibrium(oscillator, quadratic)) {
        return None;
    }
    let in_amplitude = Options {
        small: Some(AmplitudeConvention::Initial.symbol().to_string()),
        order: Some(options.order.unwrap_or(SECOND_ORDER)),
        ..options.clone()
    };
    let mut solution = solve_by(Method::MultipleScales, oscillator, &in_amplitude).ok()?;
    if !asked {
        solution.validity.push(Note::QuadraticTerms);
    }
    Some(solution)
}

/// Slow equations in powers of the amplitude, where averaging is refused for a force whose first
/// harmonic has no closed form.
///
/// # Errors
/// That refusal, where there is no expansion either.
fn in_powers(
    refusal: Refusal,
    oscillator: &Oscillator,
    options: &Options,
) -> Result<Solution, Refusal> {
    if refusal.reason != Reason::NoProjection {
        return Err(refusal);
    }
    match solve_by(Method::MultipleScales, oscillator, options) {
        Ok(mut solution) => {
            let reason = format!("it {}", refusal.without_title(Method::Averaging));
            solution.validity.push(Note::InsteadOf { usual: Method::Averaging, reason });
            Ok(solution)
        }
        Err(_) => Err(refusal),
    }
}

/// The expansion in the amplitude of a force that is not a polynomial, although a parameter might
/// have been small.
fn series_in_amplitude(oscillator: &Oscillator, options: &Options) -> Option<Solution> {
    let small = oscillator.small_parameter(None);
    matches!(small, Ok(SmallParameter::Parameter(_))).then_some(())?;
    let options = Options {
        small: Some(AmplitudeConvention::Initial.symbol().to_string()),
        ..options.clone()
    };
    solve_by(Method::LindstedtPoincare, oscillator, &options).ok()
}

/// A conservative motion about an equilibrium at which the force has no expansion, by a method that
/// takes the force as it is; `None` if it is not that, where an expansion was asked for, and if no
/// such method answers.
fn without_expansion(
    refusal: &Refusal,
    oscillator: &Oscillator,
    options: &Options,
) -> Option<Solution> {
    let Reason::Oscillator(error) = &refusal.reason else {
        return None;
    };
    let parts = oscillator.parts().ok()?;
    let conservative = parts.damping.is_zero() && parts.forcing.is_zero();
    if !conservative || !has_no_expansion(error) || options.small.is_some() {
        return None;
    }
    // A linear force that pushes away is a reason of its own, unless that equilibrium is asked for:
    // rest is unstable.
    let passed = || oscillator.about.is_some() && swings_over_a_hilltop(oscillator);
    if matches!(error, OscillatorError::NoRestoringForce(linear) if !linear.is_zero()) && !passed()
    {
        return None;
    }
    let by = |method: Method| solve_by(method, oscillator, options).ok();
    let closed = |solution: &Solution| !matches!(solution.law, Law::Quadrature(_));
    let leaves_drift = |solution: &Solution| {
        let mut notes = solution.validity.iter();
        notes.any(|note| matches!(note, Note::EvenPartLeftOut(_)))
    };
    let mut solution = match options.order {
        Some(_) => by(Method::HarmonicBalance)?,
        None => {
            let exact = by(Method::Exact);
            let hamiltonian =
                || by(Method::Hamiltonian).filter(|found| closed(found) && !leaves_drift(found));
            match exact {
                Some(exact) if closed(&exact) => exact,
                exact => match series_in_amplitude(oscillator, options) {
                    Some(series) => return Some(series),
                    None => hamiltonian().or(exact)?,
                },
            }
        }
    };
    solution
        .validity
        .push(Note::InsteadOf { usual: Method::LindstedtPoincare, reason: error.to_string() });
    Some(solution)
}

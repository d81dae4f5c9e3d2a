//! The method of Lindstedt and Poincare: strained time, secular terms eliminated order by order.
//!
//! References: A. Lindstedt, Mem. Acad. Imp. Sci. St. Petersbourg 31 (1883); H. Poincare, *Les methodes nouvelles de la
//! mecanique celeste* II (1893); A. H. Nayfeh, *Perturbation Methods*, Wiley 1973, section 3.1.
//!
//! ```text
//! x'' + omega0^2 x + sum_j delta^(a_j) c_j x^p x'^q = 0,      theta = omega t
//! x = A (y_0 + delta y_1 + ...),  omega^2 = omega0^2 (1 + delta W_1 + ...),  y_0 = cos theta
//! y'' + y + sum_j delta^(a_j) C_j y^p (omega y'/omega0)^q = 0,  C_j = c_j A^(p+q-1) omega0^(q-2)
//! ```
//!
//! What remains is [`secular::expand`](super::secular::expand), over whole numbers where every symbol can be scaled away (Duffing depends on
//! `eps*A^2` alone) and over polynomials otherwise.
//!
//! Self-excited equations determine their amplitude: `A` is then a root of the secular sine of the first order,
//! `sum_j C_j(A) [cos^p (-sin)^q]_sin = 0`.
//!
//! ```
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::LindstedtPoincare), order: Some(2), ..Options::default() };
//! let law = solve(&duffing, &options)?.frequency.unwrap();
//! assert_eq!(law.to_string(), "1 + 3*eps*A^2/8 - 21*eps^2*A^4/256");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use num_traits::{One, Zero};

use super::expansion::expand_exactly;
use super::limit_cycle::{LEADING, leading_amplitude, limit_cycle, limit_cycle_amplitude, stability};
use super::secular::{Amplitude, Detuning, Normalisation, Scheme};
use super::{Options, Refusal, first_term};
use crate::derivation::Line;
use crate::exact::{Polynomial, Rational, Ring};
use crate::expr::Expr;
use crate::oscillator::{Oscillator, OscillatorError, Parts, SmallParameter, Term};
use crate::solution::{AmplitudeConvention, Definition, Method, Solution};
use crate::symbol::Symbol;

pub(super) const TITLE: &str = "the method of Lindstedt and Poincare";

/// Derives frequency and motion as power series in the small parameter.
///
/// # Errors
/// Damping, forcing, or a force that cannot be expanded, each by name.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    let parts = oscillator.parts()?;
    if !parts.forcing.is_zero() {
        return Err(Refusal::Forcing {
            method: TITLE,
            term: first_term(&parts.forcing),
        });
    }
    let small = oscillator.small_parameter(options.small.as_deref())?;
    let order = options
        .order
        .unwrap_or(if small == SmallParameter::Amplitude { 4 } else { 2 });
    let force = match oscillator.expand(small, order) {
        // What stops the expansion is named as what it is.
        Err(OscillatorError::NotSmall { .. }) if small == SmallParameter::Amplitude && !parts.damping.is_zero() => {
            return Err(damping_or_excitation(&parts));
        }
        Err(OscillatorError::NotSmall { term, .. })
            if parts.damping.terms().iter().any(|part| part.to_string() == term) =>
        {
            return Err(Refusal::Damping { method: TITLE, term });
        }
        expanded => expanded?,
    };
    let (linear_frequency, definition) = force.linear_frequency();
    let mut definitions: Vec<Definition> = definition.into_iter().chain(force.definitions.clone()).collect();

    let cycle = match limit_cycle_amplitude(&force, &linear_frequency, &parts)? {
        Some(_) if small == SmallParameter::Amplitude => {
            return Err(Refusal::AmplitudeNotFree {
                term: first_term(&parts.damping),
            });
        }
        cycle => cycle,
    };
    let convention = options.amplitude.unwrap_or(match cycle {
        Some(_) => AmplitudeConvention::FirstHarmonic,
        None => AmplitudeConvention::Initial,
    });
    let symbol = convention.symbol();
    let (unit, amplitude) = match &cycle {
        None => (Polynomial::symbol(symbol), Amplitude::Free),
        Some(squared) => {
            let root = squared.single_term_root().unwrap_or_else(|| {
                let name = Symbol::new(LEADING);
                definitions.push(Definition {
                    symbol: name,
                    meaning: Expr::from(squared).sqrt().unwrap_or_else(|_| Expr::from(squared)),
                });
                Polynomial::symbol(name)
            });
            (root, Amplitude::Determined)
        }
    };
    let normalisation = match convention {
        AmplitudeConvention::Initial => Normalisation::Initial,
        AmplitudeConvention::FirstHarmonic => Normalisation::FirstHarmonic,
    };
    let scheme = Scheme {
        normalisation,
        amplitude,
        detuning: Detuning::Acceleration,
    };
    let scaled = scaled_terms(&force.terms, &unit, cycle.as_ref(), &linear_frequency);
    let delta = match small {
        SmallParameter::Parameter(name) => name,
        SmallParameter::Amplitude => symbol,
    };
    let series = expand_exactly(&scaled, order, &scheme, Some(delta)).map_err(|error| {
        if parts.damping.is_zero() {
            error.into()
        } else {
            damping_or_excitation(&parts)
        }
    })?;

    let mut steps = series.steps;
    if let (Some(squared), Some(start)) = (&cycle, steps.first_mut()) {
        start.amplitude = Some(leading_amplitude(&force, &linear_frequency, delta, squared));
    }
    let times = |series: Polynomial, factor: &Polynomial| series.product(factor);
    let squared_unit = times(linear_frequency.clone(), &linear_frequency);
    let displacement = series.displacement.map(|coefficient, _| coefficient.product(&unit));
    let limit_cycle = cycle.is_some().then(|| limit_cycle(&displacement, convention));
    let mut validity = vec![format!(
        "truncated after {delta}^{order}; an expansion for small {delta}"
    )];
    if cycle.is_some() {
        validity.extend(stability(&force, &linear_frequency, delta));
    }
    validity.extend(next_terms(&definitions));
    Ok(Solution {
        equation: oscillator.equation(),
        method: Method::LindstedtPoincare,
        order,
        degrees: None,
        small_parameter: delta,
        amplitude: convention,
        parameters: oscillator.parameters.clone(),
        definitions,
        equilibrium: Expr::zero(),
        frequency: Some(times(series.frequency, &linear_frequency)),
        frequency_squared: Some(times(series.frequency_squared, &squared_unit)),
        relation: None,
        closed_form: None,
        by_quadrature: None,
        system: None,
        displacement,
        limit_cycle,
        numerical: false,
        validity,
        steps,
        derivation: vec![Line::equation(Expr::symbol("omega0").integer_power(2)?, &force.linear)],
    })
}

fn next_terms(definitions: &[Definition]) -> impl Iterator<Item = String> + '_ {
    definitions
        .iter()
        .map(|definition| format!("{} = {} > 0", definition.symbol, definition.meaning))
}

/// A term that feeds energy for some motions and drains it for others is no mere damping; which it is, the sign cannot tell.
fn damping_or_excitation(parts: &Parts) -> Refusal {
    match parts.damping.terms() {
        [_] => Refusal::Damping {
            method: TITLE,
            term: first_term(&parts.damping),
        },
        _ => Refusal::AmplitudeNotFree {
            term: first_term(&parts.damping),
        },
    }
}

pub(super) fn inverse_power(single_term: &Polynomial, exponent: i32) -> Polynomial {
    single_term.power(exponent).unwrap_or_else(Polynomial::zero)
}

/// The terms in `y = x / unit` and the time of the linear frequency: `C_j` in the head of this file.
fn scaled_terms(
    terms: &[Term],
    unit: &Polynomial,
    unit_squared: Option<&Polynomial>,
    linear_frequency: &Polynomial,
) -> Vec<Term> {
    let scale = |term: &Term| {
        let exponent = (term.position + term.velocity) as i32 - 1;
        // Even powers of a limit cycle's amplitude are known even where the amplitude itself is a root.
        let unit = match unit_squared {
            Some(squared) if exponent > 0 => {
                let odd = if exponent % 2 == 1 {
                    unit.clone()
                } else {
                    Polynomial::constant(Rational::one())
                };
                inverse_power(squared, exponent / 2).product(&odd)
            }
            _ => inverse_power(unit, exponent),
        };
        let frequency = inverse_power(linear_frequency, term.velocity as i32 - 2);
        Term {
            coefficient: term.coefficient.product(&unit).product(&frequency),
            ..term.clone()
        }
    };
    terms.iter().map(scale).collect()
}

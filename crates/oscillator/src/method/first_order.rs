//! The first order of the method of Lindstedt and Poincare for a force that is not a polynomial.
//!
//! Reference: A. H. Nayfeh, *Perturbation Methods*, Wiley 1973, section 3.1, with the projection of
//! `f_1` in closed form.
//!
//! ```text
//! x'' + omega0^2 x + eps f_1(x) = 0,   x = A cos(theta) + eps x_1 + ...,   omega^2 = omega0^2 + eps w_1 + ...
//! order eps:   omega0^2 (x_1'' + x_1) = w_1 A cos(theta) - f_1(A cos(theta))
//! no cos(theta) on the right:   w_1 = c_1(A)/A,   c_1 = (2/pi) int_0^pi f_1(A cos theta) cos(theta) dtheta
//! ```
//!
//! The next order needs all harmonics of `f_1` along the motion: infinitely many where `f_1` is not
//! a polynomial.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let oscillator = Oscillator::parse("x'' + x + eps*sin(x) = 0")?;
//! let options = Options { method: Some(Method::LindstedtPoincare), order: Some(1), ..Options::default() };
//! assert_eq!(solve(&oscillator, &options)?.law.closed_form().unwrap().to_string(), "omega^2 = 1 + 2*eps*J1(A)/A");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use num_traits::Zero;

use super::one_term::{integral_law, note_even_part, set_law, shared_integral, unsolved};
use super::{Options, Reason, Refusal, Refuser, not_polynomial};
use crate::derivation::DerivationLine;
use crate::exact::Rational;
use crate::expr::Expr;
use crate::oscillator::{Oscillator, Parts, SmallParameter};
use crate::series::taylor::taylor;
use crate::solution::note::Truncation;
use crate::solution::{AmplitudeConvention, Method, Note, Solution};
use crate::symbol::Symbol;

/// The answer to first order in `small`; `None` if the equation is not conservative, not linear
/// without `small`, or its projection has no closed form.
///
/// # Errors
/// An order above the first, or the amplitude of the first harmonic.
pub(super) fn solve(
    oscillator: &Oscillator,
    parts: &Parts,
    options: &Options,
    small: Symbol,
    order: u32,
) -> Result<Option<Solution>, Refusal> {
    let of_position = parts.of_position_alone();
    // The expansion tells whether the rest is linear and restoring.
    let linear = oscillator.expand(SmallParameter::Parameter(small), 0).is_ok();
    let Some(force) = truncated(oscillator, small).filter(|_| of_position && linear) else {
        return Ok(None);
    };
    let Some(law) = shared_integral(oscillator, &force) else {
        return Ok(None);
    };
    if order > 1 {
        // The whole force is searched, because the term at a higher power of `small` may be the one
        // that is not a polynomial.
        let force = &oscillator.force;
        let perturbation = (force - &force.substitute(small, &Expr::zero())?).expand()?;
        return Err(not_polynomial(
            &perturbation,
            oscillator.coordinate,
            Method::LindstedtPoincare,
        ));
    }
    if options.amplitude == Some(AmplitudeConvention::FirstHarmonic) {
        return Err(Reason::Convention.refused_by(Refuser::FirstOrder));
    }
    let mut solution = unsolved(oscillator, options, Method::LindstedtPoincare, 1);
    solution.small_parameter = small;
    set_law(&mut solution, &law)?;
    solution.validity =
        vec![Note::Cut(Truncation::FirstOrderOnly { small }), Note::MotionAtLeadingOrder { small }];
    note_even_part(&mut solution, oscillator, &force)?;
    solution.derivation = vec![
        DerivationLine::equation(oscillator.coordinate, solution.displacement.clone())
            .because(format!("at {small}^0")),
    ];
    let law = integral_law(oscillator, &force, &solution)?;
    solution.derivation.extend(law);
    Ok(Some(solution))
}

/// The force without the powers of `small` above the first; `None` if it has no such series.
pub(super) fn truncated(oscillator: &Oscillator, small: Symbol) -> Option<Expr> {
    let parts = taylor(&oscillator.force, &[(small, Rational::zero())], 1).ok()?;
    Expr::sum(parts).expand().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::numbers::evaluate;
    use crate::method::solve;
    use std::collections::BTreeMap;
    use std::f64::consts::PI;

    fn options(order: u32) -> Options {
        Options {
            method: Some(Method::LindstedtPoincare),
            order: Some(order),
            ..Options::default()
        }
    }

    /// `c_1/A` by the midpoint rule, which knows nothing of the closed forms.
    fn projection(force: fn(f64) -> f64, amplitude: f64) -> f64 {
        const POINTS: usize = 20_000;
        let value = |i: usize| {
            let cosine = (PI * (i as f64 + 0.5) / POINTS as f64).cos();
            force(amplitude * cosine) * cosine
        };
        2.0 / (POINTS as f64 * amplitude) * (0..POINTS).map(value).sum::<f64>()
    }

    #[test]
    fn the_law_is_the_projection() {
        type Case = (&'static str, fn(f64) -> f64);
        let cases: [Case; 6] = [
            ("x'' + 4*x + eps*sin(x) = 0", f64::sin),
            ("x'' + 4*x + eps*x*abs(x) = 0", |x| x * x.abs()),
            ("x'' + 4*x + eps*x^3/(1 + x^2) = 0", |x| x.powi(3) / (1.0 + x * x)),
            ("x'' + 4*x + eps*(exp(x) - 1) = 0", f64::exp_m1),
            ("x'' + 4*x + eps*sgn(x)*abs(x)^(3/2) = 0", |x| x.signum() * x.abs().powf(1.5)),
            // The second power of eps is beyond this order.
            ("x'' + 4*x + eps*sinh(x) + eps^2*x^3 = 0", f64::sinh),
        ];
        for (text, force) in cases {
            let oscillator = Oscillator::parse(text).unwrap();
            let solution = solve(&oscillator, &options(1)).unwrap();
            assert_eq!(solution.small_parameter, Symbol::new("eps"));
            for amplitude in [1e-6, 0.3, 2.5, -2.5] {
                let numbers = BTreeMap::from([("A".into(), amplitude), ("eps".into(), 0.3)]);
                let found = evaluate(&oscillator, &solution, &numbers).unwrap().frequency_squared;
                let expected = 4.0 + 0.3 * projection(force, f64::abs(amplitude));
                assert!(
                    (found - expected).abs() < 1e-8,
                    "{text} at {amplitude}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn what_the_first_order_cannot_is_refused_with_a_way_forward() {
        for (text, order, way) in [
            ("x'' + x + eps*sin(x) = 0", 2, "order 1"),
            ("x'' + x + eps*tan(x) = 0", 1, "method"),
            ("x'' + x + sin(x) + eps*abs(x)*x = 0", 1, "method"),
        ] {
            let refusal = solve(&Oscillator::parse(text).unwrap(), &options(order)).unwrap_err();
            let help = refusal.help().expect(text).to_string();
            assert!(help.contains(way), "{text}: {refusal} {help}");
        }
        let first_harmonic =
            Options { amplitude: Some(AmplitudeConvention::FirstHarmonic), ..options(1) };
        let oscillator = Oscillator::parse("x'' + x + eps*sin(x) = 0").unwrap();
        assert!(matches!(
            solve(&oscillator, &first_harmonic),
            Err(Refusal { reason: Reason::Convention, .. })
        ));
    }
}

//! He's energy balance: the energy of a one-term motion collocated at an eighth of the period.
//!
//! Reference: J.-H. He, *Preliminary report on the energy balance for nonlinear oscillations*,
//! Mech. Res. Commun. 29 (2002) 107-111.
//!
//! ```text
//! x'^2/2 + V(x) = V(A),   x = A cos(omega t)
//! at omega t = pi/4:   omega^2 A^2/4 + V(A/sqrt(2)) = V(A)
//! omega^2 = 4 [V(A) - V(A/sqrt(2))]/A^2
//! ```
//!
//! Cost: two values of the potential.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::EnergyBalance), ..Options::default() };
//! assert_eq!(solve(&duffing, &options)?.law.frequency_squared().unwrap().to_string(), "1 + 3*eps*A^2/4");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use num_traits::{One as _, Signed};

use super::one_term::{conservative_force, first_order_only, require_odd, set_law, unsolved};
use super::{Options, Refusal};
use crate::conservative::force::CentredForce;
use crate::conservative::potential::potential;
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::exact::{Integer, Rational};
use crate::expr::{Expr, ExprError, Function, Node};
use crate::oscillator::Oscillator;
use crate::solution::{Law, Method, Note, Solution, note::CollocationInstant};
use crate::symbol::fresh;
use crate::symbol::letters::AMPLITUDE;

const METHOD: Method = Method::EnergyBalance;

/// The frequency by the energy at an eighth of the period.
///
/// # Errors
/// A force that is not conservative or not odd, by its term; an order above the first.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    first_order_only(options, METHOD)?;
    let force = conservative_force(oscillator, options, METHOD)?;
    require_odd(oscillator, &force, METHOD)?;
    let mut solution = unsolved(oscillator, options, METHOD, 1);
    let potential = potential(&force, oscillator.coordinate);
    let law = |potential: &Expr| {
        let amplitude = Expr::symbol("A");
        let at = |place: &Expr| potential.substitute(oscillator.coordinate, place).ok();
        let rise =
            at(&amplitude)? - at(&Expr::divide(&amplitude, &Expr::from(2).sqrt().ok()?).ok()?)?;
        // The logarithm of A cancels.
        let rise = logarithms_apart(&positive_amplitude(&rise)?).ok()?;
        let law = Expr::divide(&(Expr::from(4) * rise), &amplitude.integer_power(2).ok()?).ok()?;
        Some(positive_amplitude(&law)?.expand().ok()?.factored())
    };
    match potential.as_ref().and_then(law) {
        Some(law) => {
            set_law(&mut solution, &law)?;
            if let Some(potential) = &potential {
                solution.derivation = derivation(oscillator, potential)?;
                let squared = Expr::symbol("omega").integer_power(2)?;
                solution.derivation.push(DerivationLine::equation(squared, law));
            }
        }
        None => {
            let amplitude = Expr::symbol("A");
            let eighth = Expr::divide(&amplitude, &Expr::from(2).sqrt()?)?;
            let work = |factor: Expr| DerivationFormula::Integral {
                factor,
                from: eighth.clone(),
                to: amplitude.clone(),
                integrand: Box::new((&force).into()),
                variable: oscillator.coordinate,
            };
            let squared = Expr::symbol("omega").integer_power(2)?;
            let quarter = Expr::divide(&amplitude.integer_power(2)?, &Expr::from(4))?;
            let integral = work(Expr::divide(&Expr::one(), &quarter)?);
            solution.derivation = vec![
                DerivationLine::equation(&squared * &quarter, work(Expr::one())).because(format!(
                    "kinetic energy of {AMPLITUDE}*cos(θ) at θ = pi/4, from the work of the force"
                )),
                DerivationLine::equation(squared.clone(), integral.clone()),
            ];
            solution.law = Law::Quadrature(vec![DerivationLine::equation(squared, integral)]);
        }
    }
    solution.validity.push(Note::Collocated(CollocationInstant::EighthOfPeriod));
    Ok(solution)
}

/// The energy at the start and at an eighth of the period, written out.
fn derivation(oscillator: &Oscillator, potential: &Expr) -> Result<Vec<DerivationLine>, Refusal> {
    let (amplitude, omega) = (Expr::symbol("A"), Expr::symbol("omega"));
    let eighth = Expr::divide(&amplitude, &Expr::from(2).sqrt()?)?;
    let at = |place: &Expr| {
        let value = potential.substitute(oscillator.coordinate, place)?;
        positive_amplitude(&value).unwrap_or(value).expand()
    };
    let kinetic = Expr::divide(&(&omega * &amplitude).integer_power(2)?, &Expr::from(4))?;
    Ok(vec![
        DerivationLine::equation(fresh("V", &oscillator.names()), potential)
            .because("potential energy"),
        DerivationLine::equation(kinetic + at(&eighth)?, at(&amplitude)?).because(format!(
            "kinetic and potential energy of {AMPLITUDE}*cos(θ) at θ = pi/4, and at θ = 0"
        )),
    ])
}

/// `log(sqrt(2)*A/2) = log(A) - log(2)/2`: logarithms of products of whole numbers, their roots and
/// the positive amplitude as sums.
fn logarithms_apart(law: &Expr) -> Result<Expr, ExprError> {
    let amplitude = Expr::symbol("A");
    let logarithm = |of: Expr| Expr::function(Function::Log, vec![of]);
    law.fold(|expr, children: &[Expr]| {
        let (Node::Function(Function::Log, _), [inside]) = (expr.node(), children) else {
            return expr.with_children(children);
        };
        let (number, factors) = inside.factors();
        let known = |factor: &Expr| {
            let (base, exponent) = factor.base_and_exponent();
            let positive = base == amplitude || base.as_number().is_some_and(Signed::is_positive);
            positive && exponent.as_number().is_some()
        };
        if !number.is_positive()
            || factors.len() + usize::from(!number.is_one()) < 2
            || !factors.iter().all(known)
        {
            return expr.with_children(children);
        }
        let whole = |part: &Integer| logarithm(Expr::number(Rational::from_integer(part.clone())));
        let mut sum = whole(number.numer())? - whole(number.denom())?;
        for factor in factors {
            let (base, exponent) = factor.base_and_exponent();
            sum = sum + exponent * logarithm(base)?;
        }
        Ok(sum)
    })
}

/// `abs` and `sgn` of the positive amplitude resolved: `|A| = A`.
pub(super) fn positive_amplitude(law: &Expr) -> Option<Expr> {
    let amplitude = Expr::symbol("A");
    law.fold(|expr, children: &[Expr]| match (expr.node(), children) {
        (Node::Function(Function::Absolute | Function::Sign, _), [inside]) => {
            let (number, factors) = inside.factors();
            let size = |factor: &Expr| factor.base_and_exponent().0;
            let known = factors
                .iter()
                .all(|factor| size(factor) == amplitude || factor.symbols().is_empty());
            let sign = expr.with_children(&[Expr::number(number)])?;
            match (expr.node(), known) {
                (Node::Function(Function::Sign, _), true) => Ok(sign),
                (_, true) => Ok(sign * Expr::product(factors.iter().cloned())),
                _ => expr.with_children(children),
            }
        }
        _ => expr.with_children(children),
    })
    .ok()
}

/// The law by the work of the force, which loses no digits where a difference of potentials would.
pub(super) fn by_quadrature(force: &CentredForce, amplitude: f64) -> Option<(f64, f64)> {
    let (rise, error) = force.work(amplitude / f64::sqrt(2.0), amplitude)?;
    // Not over A^2 at once, which may leave the range of doubles.
    Some((4.0 * (rise / amplitude) / amplitude, error / rise.abs()))
}

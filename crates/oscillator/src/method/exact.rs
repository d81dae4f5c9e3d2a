//! The exact frequency: elliptic integrals and Gamma functions where the force is one of those that
//! lead to them, quadrature for any other.
//!
//! References: L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., section 11; P. F. Byrd, M. D.
//! Friedman, *Handbook of Elliptic Integrals*, 2nd ed., Springer 1971, 235 and 263; A. Belendez et
//! al., *Closed-form exact solutions for the unforced quintic nonlinear oscillator*, Adv. Math.
//! Phys. 2017, 7396063.
//!
//! ```text
//! T = 2 int_(x_1)^A dx/sqrt(2 (V(A) - V(x)))
//! c sgn(x)|x|^n:        omega = sqrt(pi c (n+1)/2) A^((n-1)/2) Gamma(1/2 + 1/(n+1))/Gamma(1/(n+1)),   n > -1
//! c/x, its limit:       omega = sqrt(pi c/2)/A,   by x = A exp(-s^2): T = 4 A sqrt(2/c) int_0^inf exp(-s^2) ds
//! k sin(c x):           omega = pi sqrt(k c)/(2 K(sin^2(c A/2)))
//! k sinh(c x):          omega = pi sqrt(k c)/(2 K(-sinh^2(c A/2)))
//! a x + b x^3 + l x^5:  with x = A cos phi, t = tan phi, p = a + b A^2 + l A^4, r = a + b A^2/2 + l A^4/3, q = 2 r + (b/2 + l A^2/3) A^2:
//!   T = 4 int_0^inf dt/sqrt(r t^4 + q t^2 + p),   omega = pi (p r)^(1/4)/(2 K(1/2 - q/(4 sqrt(p r))))
//! a x + b x^3:          omega = pi sqrt(a + b A^2)/(2 K(b A^2/(2 (a + b A^2))))
//! a x + b x^2:          omega = pi sqrt((P + D)/2)/(2 K((P - D)/(P + D))),  P = a + 2 b A,  D^2 = a^2 - 4 a b A/3 - 4 b^2 A^2/3
//! ```
//!
//! and the motions, by the elliptic functions of Jacobi of these parameters `m` (NIST Digital
//! Library of Mathematical Functions 22.19):
//!
//! ```text
//! k sin(c x):           x = (2/c) asin(sin(c A/2) sn(sqrt(k c) t + K(m), m))
//! k sinh(c x):          x = (2/c) asinh(sinh(c A/2) cn(sqrt(k c) cosh(c A/2) t, tanh(c A/2)^2))
//! a x + b x^3 + l x^5:  x = A cn/sqrt(cn^2 + sqrt(p/r) sn^2 dn^2),   all of (p r)^(1/4) t
//! a x + b x^3:          x = A cn(sqrt(a + b A^2) t, m)
//! a x + b x^2:          x = A - 4 A (a + b A)/(P + D) sn^2(sqrt((P + D)/8) t, m)
//! ```
//!
//! Cost: a closed form in constant time, or one quadrature for each amplitude.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
//! let options = Options { method: Some(Method::Exact), ..Options::default() };
//! assert_eq!(solve(&pendulum, &options)?.law.closed_form().unwrap().to_string(), "omega = pi/(2*K(sin(A/2)^2))");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use num_traits::{One, Zero};

use super::energy_balance::positive_amplitude;
use super::iteration_perturbation::polynomial_coefficients;
use super::linear::{Linear, is_free_and_linear};
use super::one_term::{conservative_force, unsolved};
use super::{Options, Refusal};
use crate::conservative::potential::potential;
use crate::conservative::power::Power;
use crate::conservative::{is_odd, linear_in, split, take_powers};
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::exact::rational::ratio;
use crate::exact::{POLYNOMIALS, Polynomial, Rational};
use crate::expr::{Expr, ExprError, Function, Node};
use crate::oscillator::Oscillator;
use crate::series::FourierSeries;
use crate::solution::{ClosedForm, Law, Method, Note, Solution, note::ExactBy};
use crate::symbol::fresh;
use crate::symbol::letters::AMPLITUDE;

/// The exact law of a conservative oscillator, whose motion is known by numbers; the exact motion
/// of a linear one that something damps or drives.
///
/// # Errors
/// A force that is neither conservative nor linear, by its term.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    const METHOD: Method = Method::Exact;
    if let Some(linear) = Linear::new(oscillator)? {
        return linear.solve(oscillator, options);
    }
    let force = conservative_force(oscillator, options, METHOD)?;
    let mut solution = unsolved(oscillator, options, METHOD, 0);
    solution.displacement = FourierSeries::zero(POLYNOMIALS);
    let known = match polynomial_coefficients(oscillator, &force)? {
        Some(coefficients) => of_polynomial(&coefficients)?,
        None => of_function(oscillator, &force)?,
    };
    let (law, motion) = known.map_or((None, None), |known| (Some(known.law), known.motion));
    solution.law = match law {
        Some(Frequency::Squared(squared)) => Law::squared(squared),
        Some(Frequency::Plain(frequency)) => Law::Frequency(frequency),
        Some(Frequency::Form(value)) => Law::Closed(ClosedForm { squared: false, value }),
        None => Law::Quadrature(period_by_energy(oscillator, &force)?),
    };
    let is_elliptic = |motion: &Expr| {
        use Function::{JacobiCn, JacobiDn, JacobiSn};
        [JacobiSn, JacobiCn, JacobiDn]
            .into_iter()
            .any(|function| motion.contains_function(function))
    };
    let by_jacobi = motion.as_ref().is_some_and(is_elliptic);
    solution.closed_motion = motion;
    solution.derivation = period_by_energy(oscillator, &force)?;
    solution.validity.push(Note::Exact(match solution.law.quadrature() {
        None if is_free_and_linear(oscillator)? => ExactBy::Linear,
        None => ExactBy::ClosedForm,
        Some(_) => ExactBy::Quadrature,
    }));
    solution.validity.extend(by_jacobi.then_some(Note::EllipticFunctions));
    Ok(solution)
}

/// The period as an integral over the energy, with the force of this equation in it.
fn period_by_energy(oscillator: &Oscillator, force: &Expr) -> Result<Vec<DerivationLine>, Refusal> {
    let x = oscillator.coordinate;
    let energy = EnergyIntegral {
        force,
        potential: potential(force, x),
        root_of_mass: Expr::one(),
        is_odd: is_odd(force, x)?,
    };
    energy.period(oscillator)
}

/// The energy `M x'^2/2 + U`, from which the period follows.
pub(super) struct EnergyIntegral<'a> {
    /// `U'`.
    pub(super) force: &'a Expr,
    /// `U`, where it has a closed form.
    pub(super) potential: Option<Expr>,
    /// `sqrt(M)`, one for a mass that does not change.
    pub(super) root_of_mass: Expr,
    /// Whether `U` and `M` are even.
    pub(super) is_odd: bool,
}

impl EnergyIntegral<'_> {
    /// `T = 2 int_(x_1)^A sqrt(M)/sqrt(2 (U(A) - U(x))) dx`, and where `x_1` comes from.
    pub(super) fn period(&self, oscillator: &Oscillator) -> Result<Vec<DerivationLine>, Refusal> {
        let (x, amplitude) = (oscillator.coordinate, Expr::symbol("A"));
        let names = oscillator.names();
        let [variable, total, turning_back] = ["u", "T", "x1"].map(|name| fresh(name, &names));
        // The potential in closed form, if it has one.
        let at = |place: &Expr| -> Option<Expr> {
            let value = self.potential.as_ref()?.substitute(x, place).ok()?;
            // A is taken to be positive only for an even potential, whose turning points are A and
            // -A.
            let value = if self.is_odd { positive_amplitude(&value)? } else { value };
            value.expand().ok()
        };
        let gained = at(&amplitude).zip(at(&x.into()));
        let gained =
            gained.and_then(|(turning, here)| (Expr::from(2) * (turning - here)).expand().ok());
        let gained: DerivationFormula = gained.map_or_else(
            || {
                Ok::<_, Refusal>(DerivationFormula::Integral {
                    factor: Expr::from(2),
                    from: x.into(),
                    to: amplitude.clone(),
                    integrand: Box::new(self.force.substitute(x, &variable.into())?.into()),
                    variable,
                })
            },
            |gained| Ok(gained.into()),
        )?;
        let (factor, from) =
            if self.is_odd { (4, Expr::zero()) } else { (2, Expr::from(turning_back)) };
        let mut lines = Vec::new();
        if !self.is_odd {
            let equal: [DerivationFormula; 2] = match at(&from).zip(at(&amplitude)) {
                Some((there, here)) => [there.into(), here.into()],
                None => {
                    let work = DerivationFormula::Integral {
                        factor: Expr::one(),
                        from: from.clone(),
                        to: amplitude.clone(),
                        integrand: Box::new(self.force.into()),
                        variable: x,
                    };
                    [work, Expr::zero().into()]
                }
            };
            lines.push(DerivationLine::equal(equal).because(format!(
                "the other turning point {turning_back}, of the other sign than {AMPLITUDE}"
            )));
        }
        let period = DerivationFormula::Integral {
            factor: Expr::from(factor),
            from,
            to: amplitude,
            integrand: Box::new(DerivationFormula::OverRoot(
                self.root_of_mass.clone(),
                Box::new(gained),
            )),
            variable: x,
        };
        let words = match self.is_odd {
            true => "the period, from the energy".to_owned(),
            false => format!(
                "the period, from the energy; for {AMPLITUDE} < 0 from {AMPLITUDE} to {turning_back}"
            ),
        };
        lines.push(DerivationLine::equation(total, period).because(words));
        let frequency = Expr::divide(&(Expr::from(2) * Expr::pi()), &Expr::from(total))?;
        lines.push(DerivationLine::equation("omega", frequency));
        Ok(lines)
    }
}

/// Properties of a force.
struct ForceProperties {
    law: Frequency,
    /// `x(t)` from rest at `A`, about the equilibrium.
    motion: Option<Expr>,
}

enum Frequency {
    Squared(Polynomial),
    Plain(Polynomial),
    Form(Expr),
}

impl ForceProperties {
    fn form(value: Expr, motion: Option<Expr>) -> Self {
        Self { law: Frequency::Form(value), motion }
    }
}

fn time() -> Expr {
    Expr::symbol("t")
}

/// `sn`, `cn` and `dn` of an argument and a parameter.
fn jacobi(argument: &Expr, parameter: &Expr) -> Result<[Expr; 3], ExprError> {
    let of = |function| Expr::function(function, vec![argument.clone(), parameter.clone()]);
    Ok([of(Function::JacobiSn)?, of(Function::JacobiCn)?, of(Function::JacobiDn)?])
}

fn half() -> Expr {
    Expr::number(ratio(1, 2))
}

fn elliptic(parameter: Expr) -> Result<Expr, ExprError> {
    Expr::function(Function::EllipticK, vec![parameter.expand()?])
}

/// `pi scale/(2 K(parameter))`.
fn by_elliptic(scale: &Expr, parameter: Expr) -> Result<Expr, ExprError> {
    Expr::divide(&(Expr::pi() * scale), &(Expr::from(2) * elliptic(parameter)?))
}

fn of_polynomial(coefficients: &[Polynomial]) -> Result<Option<ForceProperties>, Refusal> {
    let powers: Vec<usize> =
        (0..coefficients.len()).filter(|&n| !coefficients[n].is_zero()).collect();
    let of = |n: usize| coefficients.get(n).map_or_else(Expr::zero, Expr::from);
    let amplitude = Expr::symbol("A");
    let squared = amplitude.integer_power(2)?;
    match powers.as_slice() {
        [1] => {
            let squared = coefficients.get(1).cloned().unwrap_or_else(Polynomial::zero);
            let (rate, law) = match squared.single_term_root() {
                Some(root) => (Expr::from(&root), Frequency::Plain(root)),
                None => (of(1).sqrt()?, Frequency::Squared(squared)),
            };
            let motion = &amplitude * &(rate * time()).cos()?;
            Ok(Some(ForceProperties { law, motion: Some(motion) }))
        }
        [n] if n % 2 == 1 => {
            let law = of_power(&of(*n), &Expr::number(Rational::from_integer((*n).into())))?;
            let motion = match n {
                3 => {
                    let [_, cn, _] = jacobi(&(of(3).sqrt()? * &amplitude * time()), &half())?;
                    Some(&amplitude * &cn)
                }
                _ => None,
            };
            Ok(Some(ForceProperties::form(law, motion)))
        }
        [1, 2] => {
            let (a, b) = (of(1), of(2));
            let product = &b * &amplitude;
            let p = &a + &(Expr::from(2) * &product);
            let third = |n: i64| Expr::number(ratio(n, 3));
            let inside = a.integer_power(2)?
                - third(4) * &a * &product
                - third(4) * product.integer_power(2)?;
            let d = inside.expand()?.sqrt()?;
            let sum = &p + &d;
            let scale = (&sum * &half()).sqrt()?;
            let parameter = Expr::divide(&(&p - &d), &sum)?;
            let law = Expr::divide(
                &(Expr::pi() * scale),
                &(Expr::from(2) * Expr::function(Function::EllipticK, vec![parameter.clone()])?),
            )?;
            let rate = (&sum * &Expr::number(ratio(1, 8))).sqrt()?;
            let [sn, ..] = jacobi(&(rate * time()), &parameter)?;
            let width = Expr::divide(&(Expr::from(4) * &amplitude * (&a + &product)), &sum)?;
            let motion = &amplitude - &(width * sn.integer_power(2)?);
            Ok(Some(ForceProperties::form(law, Some(motion))))
        }
        [1, 3] => {
            let (a, stiff) = (of(1), of(3) * &squared);
            let sum = &a + &stiff;
            let parameter = Expr::divide(&stiff, &(Expr::from(2) * &sum))?;
            let law = Expr::divide(
                &(Expr::pi() * sum.sqrt()?),
                &(Expr::from(2) * Expr::function(Function::EllipticK, vec![parameter.clone()])?),
            )?;
            let [_, cn, _] = jacobi(&(sum.sqrt()? * time()), &parameter)?;
            Ok(Some(ForceProperties::form(law, Some(&amplitude * &cn))))
        }
        [1, 5] | [3, 5] | [1, 3, 5] => {
            let (a, b, l) = (of(1), of(3) * &squared, of(5) * squared.integer_power(2)?);
            let p = &a + &b + &l;
            let r = &a + &(&b * &half()) + &l * &Expr::number(ratio(1, 3));
            let q = Expr::from(2) * &r + &b * &half() + &l * &Expr::number(ratio(1, 3));
            let product = (&p * &r).expand()?;
            let quarter = Expr::power(&product, &Expr::number(ratio(1, 4)))?;
            let parameter =
                half() - Expr::divide(&q.expand()?, &(Expr::from(4) * product.sqrt()?))?;
            let law = Expr::divide(
                &(Expr::pi() * &quarter),
                &(Expr::from(2) * Expr::function(Function::EllipticK, vec![parameter.clone()])?),
            )?;
            let [sn, cn, dn] = jacobi(&(quarter * time()), &parameter)?;
            let share = Expr::divide(&p, &r)?.sqrt()? * (sn * dn).integer_power(2)?;
            let below = (cn.integer_power(2)? + share).sqrt()?;
            let motion = Expr::divide(&(&amplitude * &cn), &below)?;
            Ok(Some(ForceProperties::form(law, Some(motion))))
        }
        _ => Ok(None),
    }
}

/// The square root of a product as a number times one root, of pi among its factors: `sqrt(6*pi)/2`
/// for 3 pi/2.
fn single_root(product: &Expr) -> Result<Expr, ExprError> {
    let (number, factors) = product.factors();
    // sqrt(p/q) = sqrt(p q)/q, and sqrt(p q) is a number times the root of one without squares.
    let over = Rational::from_integer(number.denom().clone());
    let root = Expr::number(&number * &over * &over).sqrt()?;
    let (outside, roots) = root.factors();
    let inside = roots.iter().map(|root| root.base_and_exponent().0);
    let root = Expr::product(inside.chain(factors.iter().cloned())).sqrt()?;
    Ok(Expr::number(outside / over) * root)
}

/// `sqrt(pi c (n+1)/2) A^((n-1)/2) Gamma(1/2 + 1/(n+1))/Gamma(1/(n+1))`.
pub(super) fn of_power(coefficient: &Expr, n: &Expr) -> Result<Expr, ExprError> {
    let gamma = |argument: Expr| Expr::function(Function::Gamma, vec![argument]);
    let next = n + &Expr::one();
    let scale = single_root(&(Expr::pi() * (coefficient * &Expr::divide(&next, &Expr::from(2))?)))?;
    let half_of_last = Expr::divide(&(n - &Expr::one()), &Expr::from(2))?;
    let amplitude = Expr::power(&Expr::symbol("A"), &half_of_last)?;
    let inverse = Expr::divide(&Expr::one(), &next)?;
    Expr::divide(&(scale * amplitude * gamma(half() + &inverse)?), &gamma(inverse)?)
}

/// Exact results for a linear force whose stiffness is a function of parameters, or for a single
/// term: a power with its sign, a sine or a hyperbolic sine.
fn of_function(oscillator: &Oscillator, force: &Expr) -> Result<Option<ForceProperties>, Refusal> {
    let coordinate = oscillator.coordinate;
    if is_free_and_linear(oscillator)? {
        let stiffness = force.differentiate(coordinate)?.expand()?;
        let rate = stiffness.sqrt()?;
        let motion = Expr::symbol("A") * (&rate * &time()).cos()?;
        return Ok(Some(ForceProperties::form(rate, Some(motion))));
    }
    let [term] = force.terms() else {
        return Ok(None);
    };
    let (mut outside, mut inside) = split(term, coordinate);
    if let [factor] = inside.as_slice()
        && let Node::Function(function @ (Function::Sin | Function::Sinh), arguments) =
            factor.node()
        && let Some((slope, phase)) =
            arguments.first().and_then(|argument| linear_in(argument, coordinate))
        && phase.is_zero()
    {
        let scale = (&outside * &slope).expand()?.sqrt()?;
        let angle = Expr::divide(&(&slope * &Expr::symbol("A")), &Expr::from(2))?;
        let sine = Expr::function(*function, vec![angle.clone()])?;
        let squared = sine.integer_power(2)?;
        if *function == Function::Sinh {
            // With s = sinh(c x/2) the energy is s'^2 = k c (1 + s^2) (S^2 - s^2), S the largest s:
            // s = S cn.
            let of_angle = |function| Expr::function(function, vec![angle.clone()]);
            let rate = &scale * &of_angle(Function::Cosh)?;
            let [_, cn, _] =
                jacobi(&(rate * time()), &of_angle(Function::Tanh)?.integer_power(2)?)?;
            let turned = Expr::function(Function::Asinh, vec![sine * cn])?;
            let motion = Expr::divide(&(Expr::from(2) * turned), &slope)?;
            return Ok(Some(ForceProperties::form(by_elliptic(&scale, -squared)?, Some(motion))));
        }
        let quarter = elliptic(squared.clone())?;
        let [sn, ..] = jacobi(&(&scale * &time() + quarter), &squared)?;
        let turned = Expr::function(Function::Asin, vec![sine * sn])?;
        let motion = Expr::divide(&(Expr::from(2) * turned), &slope)?;
        return Ok(Some(ForceProperties::form(by_elliptic(&scale, squared)?, Some(motion))));
    }
    // A power whose exponent is a symbol.
    let mut power = Power::one();
    if inside.iter().all(|factor| power.absorb(factor, coordinate))
        && power.exponent.as_number().is_none()
    {
        let form = power.odd.then(|| of_power(&outside, &power.exponent)).transpose()?;
        return Ok(form.map(|form| ForceProperties::form(form, None)));
    }
    match take_powers(&mut inside, &mut outside, coordinate) {
        Some(power) if inside.is_empty() && power.odd && power.exponent == -Rational::one() => {
            let scale = Expr::divide(&(Expr::pi() * &outside), &Expr::from(2))?.expand()?.sqrt()?;
            Ok(Some(ForceProperties::form(Expr::divide(&scale, &Expr::symbol("A"))?, None)))
        }
        Some(power) if inside.is_empty() && power.odd && power.exponent > -Rational::one() => {
            let law = of_power(&outside, &Expr::number(power.exponent))?;
            Ok(Some(ForceProperties::form(law, None)))
        }
        _ => Ok(None),
    }
}

//! Inertia that depends on the position: `x'' + g(x) x'^2 + h(x) = 0`, a bead on a turning wire or
//! a mass on a rod.
//!
//! Reference: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, sections 2.1 and 4.1;
//! P. M. Mathews, M. Lakshmanan, *On a unique nonlinear oscillator*, Quart. Appl. Math. 32 (1974)
//! 215-218 (a case that is known exactly).
//!
//! ```text
//! M = exp(2 int g dx),   U' = M h:     M x'^2/2 + U = U(A)              the energy
//! exact:              T = 2 int_(x_1)^A sqrt(M)/sqrt(2 (U(A) - U)) dx
//! energy balance:     M(x) omega^2 A^2/4 = U(A) - U(x),   x = A/sqrt(2)   x = A cos(theta) at theta = pi/4
//! Hamiltonian:        omega^2 dK/dA = dP/dA,   K = <M (A^2 - x^2)>/2,   P = <U>   means over x = A cos(theta)
//! harmonic balance:   the equation as it was typed, projected on cos(k theta), with x' = omega x_theta
//! ```
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let oscillator = Oscillator::parse("(1 + x^2)*x'' + x*x'^2 + x = 0")?;
//! let options = Options { method: Some(Method::Hamiltonian), ..Options::default() };
//! assert_eq!(solve(&oscillator, &options)?.law.closed_form().unwrap().to_string(), "omega^2 = 2/(2 + A^2)");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::cell::RefCell;
use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use num_traits::Zero;

use super::energy_balance::positive_amplitude;
use super::exact::EnergyIntegral;
use super::exact_motion::weighted_motion;
use super::harmonic_balance::{coefficient_names, harmonics};
use super::one_term::{compiled, first_order_only, require_odd, set_law, unsolved};
use super::table::MethodEntry;
use super::{Options, Reason, Refusal};
use crate::conservative::force::CentredForce;
use crate::conservative::is_odd;
use crate::conservative::potential::potential;
use crate::conservative::projection::cosine_coefficient;
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::exact::rational::ratio;
use crate::exact::{Doubles, POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::{CompiledFunction, Expr, ExprError, Function, Node};
use crate::numeric::ode::energy;
use crate::numeric::ode::newton::{Progress, newton};
use crate::numeric::ode::quadrature::integrate_smooth;
use crate::oscillator::Oscillator;
use crate::series::FourierSeries;
use crate::series::taylor::taylor;
use crate::solution::{
    AlgebraicSystem, AmplitudeConvention, Law, Method, Note, Solution,
    note::{CollocationInstant, ExactBy, ExactFirstStep},
};
use crate::symbol::letters::{AMPLITUDE, FREQUENCY};
use crate::symbol::{Symbol, fresh};

/// The two functions of `x'' + g x'^2 + h = 0`, and the mass `M` of the energy.
pub(super) struct VariableMass {
    growth: Expr,
    force: Expr,
    /// `M`, where the integral of `g` has a closed form.
    mass: Option<Expr>,
}

impl VariableMass {
    /// The parts of an equation whose inertia depends on the position; `None` for any other.
    ///
    /// # Errors
    /// The force cannot be written out.
    pub(super) fn from_oscillator(oscillator: &Oscillator) -> Result<Option<Self>, Refusal> {
        let parts = oscillator.parts()?;
        let velocity = oscillator.velocity();
        if parts.inertia.is_zero() || !parts.damping.is_zero() || !parts.forcing.is_zero() {
            return Ok(None);
        }
        let growth =
            Expr::divide(&parts.inertia, &Expr::from(velocity).integer_power(2)?)?.expand()?;
        if growth.contains(velocity) {
            return Ok(None);
        }
        let mass = integrating_factor(2, &growth, oscillator.coordinate);
        Ok(Some(Self { growth, force: parts.restoring, mass }))
    }

    /// Whether the motion has odd harmonics alone.
    fn is_odd(&self, oscillator: &Oscillator) -> Result<bool, ExprError> {
        Ok(is_odd(&self.force, oscillator.coordinate)?
            && is_odd(&self.growth, oscillator.coordinate)?)
    }

    /// Whether the inertia has a value at the equilibrium, from where `M` is measured, and is not
    /// zero there.
    fn has_value_at_rest(&self, oscillator: &Oscillator) -> bool {
        let x = oscillator.coordinate;
        // The value at rest of a quotient such as sin(x)/x is the first coefficient of its series.
        let at_rest = |function: &Expr| {
            let value = function.substitute(x, &Expr::zero()).ok();
            value.or_else(|| taylor(function, &[(x, Rational::zero())], 0).ok()?.first().cloned())
        };
        match &self.mass {
            Some(mass) => at_rest(mass).is_some_and(|mass| !mass.is_zero()),
            None => {
                // A function that grows less than 1/x leaves its integral finite.
                let leaves_integral =
                    |product: Expr| at_rest(&product).is_some_and(|value| value.is_zero());
                at_rest(&self.growth).is_some()
                    || (&self.growth * &Expr::from(x)).expand().is_ok_and(leaves_integral)
            }
        }
    }

    /// `M h`, whose integral is the potential energy.
    fn weighted_force(&self) -> Option<Expr> {
        (self.mass.as_ref()? * &self.force).expand().ok()
    }

    /// `M` at numbers: in closed form, or by quadrature of `g` from the equilibrium, stored at
    /// steps of a fraction of the amplitude, because the callers integrate over it in turn.
    fn mass_at(
        &self,
        oscillator: &Oscillator,
        numbers: &BTreeMap<Symbol, f64>,
        amplitude: f64,
    ) -> Option<Box<dyn Fn(f64) -> f64>> {
        const STEPS: f64 = 16.0;
        /// Number of steps beyond which a position counts as out of reach.
        const FURTHEST: f64 = 1e5;
        if let Some(mass) = &self.mass {
            return Some(Box::new(compiled(oscillator, mass, numbers)?));
        }
        let growth = compiled(oscillator, &self.growth, numbers)?;
        let step = amplitude.abs() / STEPS;
        let integral = move |from: f64, to: f64| {
            // A small exponent need not be known to as many digits: near the equilibrium, quotients
            // of zeros have fewer.
            let size = growth(0.5 * (from + to)) * (to - from);
            let tolerance = (1e-14 / size.abs()).clamp(1e-13, 1e-2);
            let integral = integrate_smooth(&growth, from, to, tolerance);
            integral.map_or(f64::NAN, |(value, _)| value)
        };
        // From the equilibrium to each step on its right, and on its left.
        let known = RefCell::new([vec![0.0], vec![0.0]]);
        Some(Box::new(move |x: f64| {
            let steps = (x / step).trunc();
            if steps.is_nan() || steps.abs() > FURTHEST {
                return f64::NAN;
            }
            let side = &mut known.borrow_mut()[usize::from(steps < 0.0)];
            while side.len() <= steps.abs() as usize {
                let end = (side.len() as f64 * step).copysign(steps);
                let more = integral(end - step.copysign(steps), end);
                side.push(side[side.len() - 1] + more);
            }
            let value = side[steps.abs() as usize] + integral(steps * step, x);
            (2.0 * value).exp()
        }))
    }
}

/// The mass M of the energy `M x'^2/2 + U` and the force `U' = M h` of an equation whose inertia depends on the
/// position; `None` for any other, and where M has no closed form.
pub fn mass_and_force(oscillator: &Oscillator) -> Option<[Expr; 2]> {
    let moving = VariableMass::from_oscillator(oscillator).ok()??;
    let mass = moving.mass?;
    let force = (&mass * &moving.force).expand().ok()?;
    Some([mass, force])
}

/// `M h`, whose integral is the potential energy, and `h`, of an equation whose inertia depends on
/// the position; `None` for any other, and where `M` has no closed form.
pub fn forces(oscillator: &Oscillator) -> Option<[Expr; 2]> {
    let moving = VariableMass::from_oscillator(oscillator).ok()??;
    Some([moving.weighted_force()?, moving.force])
}

/// `exp(n int g dx)`, logarithms in the exponent written as powers.
fn integrating_factor(n: i64, growth: &Expr, coordinate: Symbol) -> Option<Expr> {
    let exponent = (Expr::from(n) * potential(growth, coordinate)?).expand().ok()?;
    let factor = |term: &Expr| -> Result<Expr, ExprError> {
        let (number, factors) = term.factors();
        match factors {
            [logarithm] if let Node::Function(Function::Log, arguments) = logarithm.node() => {
                let argument = arguments.first().cloned().unwrap_or_else(Expr::one);
                Expr::power(&argument, &Expr::number(number))
            }
            _ => Expr::function(Function::Exp, vec![term.clone()]),
        }
    };
    let factors = exponent.terms().iter().map(factor).collect::<Result<Vec<_>, _>>().ok()?;
    Some(Expr::product(factors))
}

/// omega^2 and the motion.
type AtNumbers = (f64, FourierSeries<Doubles>);

/// The way in which a method takes equations with a position-dependent inertia.
#[derive(Clone, Copy)]
pub struct Approach {
    solve: fn(&VariableMass, &Oscillator, &Options) -> Result<Solution, Refusal>,
    /// The answer at numbers, where the law is not explicit.
    numbers: fn(&EquationAtNumbers) -> Option<AtNumbers>,
}

/// The true motion.
pub(super) const EXACT: Approach = Approach { solve: exact, numbers: exact_at };

/// Energy at an eighth of the period.
pub(super) const ENERGY_BALANCE: Approach =
    Approach { solve: energy_balance, numbers: energy_balance_at };

/// The mean Hamiltonian.
pub(super) const HAMILTONIAN: Approach = Approach { solve: hamiltonian, numbers: hamiltonian_at };

/// The harmonics of the equation as typed, balanced.
pub(super) const HARMONIC_BALANCE: Approach =
    Approach { solve: harmonic_balance, numbers: harmonic_balance_at };

/// The answer of a method that takes such an equation as it is; `None` if it does not, or the
/// equation is another.
///
/// # Errors
/// As for the method on any other equation.
pub(super) fn solve(
    entry: &MethodEntry,
    oscillator: &Oscillator,
    options: &Options,
) -> Result<Option<Solution>, Refusal> {
    let Some(approach) = entry.inertia else {
        return Ok(None);
    };
    let Some(moving) = VariableMass::from_oscillator(oscillator)? else {
        return Ok(None);
    };
    if options.amplitude == Some(AmplitudeConvention::FirstHarmonic) {
        return Err(Reason::Convention.to(entry.method));
    }
    if !moving.has_value_at_rest(oscillator) {
        let inertia = oscillator.parts()?.inertia;
        return Err(Reason::NoInertiaAtRest.to(entry.method).about(&inertia));
    }
    (approach.solve)(&moving, oscillator, options).map(Some)
}

/// The name of something in a derivation: `M`, `U`, ..., or another name where the equation uses
/// this one.
fn named(wanted: &str, oscillator: &Oscillator) -> Symbol {
    fresh(wanted, &oscillator.names())
}

/// `M`, by name.
fn mass_name(oscillator: &Oscillator) -> Symbol {
    named("M", oscillator)
}

fn mass_lines(
    moving: &VariableMass,
    oscillator: &Oscillator,
) -> Result<Vec<DerivationLine>, Refusal> {
    let (x, velocity) = (oscillator.coordinate, Expr::from(oscillator.velocity()));
    let (name, potential) = (mass_name(oscillator), named("U", oscillator));
    let mass = match &moving.mass {
        Some(mass) => DerivationLine::equation(name, mass),
        None => {
            let variable = named("u", oscillator);
            let exponent = DerivationFormula::Integral {
                factor: Expr::from(2),
                from: Expr::zero(),
                to: x.into(),
                integrand: Box::new(moving.growth.substitute(x, &variable.into())?.into()),
                variable,
            };
            let logarithm = Expr::function(Function::Log, vec![name.into()])?;
            DerivationLine::equation(logarithm, exponent)
        }
    };
    let kinetic = Expr::from(name) * velocity.integer_power(2)?;
    let energy = Expr::divide(&kinetic, &Expr::from(2))? + Expr::from(potential);
    let slope = DerivationFormula::Slope { factor: Expr::one(), of: potential, by: x };
    let weighted = moving.weighted_force();
    let weighted = weighted.unwrap_or_else(|| Expr::from(name) * &moving.force);
    Ok(vec![
        mass.because(format!("times {name} the equation has an energy")),
        DerivationLine::equation(named("E", oscillator), energy),
        DerivationLine::equation(slope, weighted),
    ])
}

fn exact(
    moving: &VariableMass,
    oscillator: &Oscillator,
    options: &Options,
) -> Result<Solution, Refusal> {
    let mut solution = unsolved(oscillator, options, Method::Exact, 0);
    solution.displacement = FourierSeries::zero(POLYNOMIALS);
    let x = oscillator.coordinate;
    let closed = moving.mass.as_ref().and_then(|_| {
        let root = integrating_factor(1, &moving.growth, x)?;
        Some((root, moving.weighted_force()?))
    });
    let named_mass = Expr::from(mass_name(oscillator));
    let named_force = &named_mass * &moving.force;
    let energy = match &closed {
        Some((root, force)) => EnergyIntegral {
            force,
            potential: potential(force, x),
            root_of_mass: root.clone(),
            is_odd: moving.is_odd(oscillator)?,
        },
        None => EnergyIntegral {
            force: &named_force,
            potential: None,
            root_of_mass: named_mass.sqrt()?,
            is_odd: moving.is_odd(oscillator)?,
        },
    };
    let mut lines = match moving.mass {
        Some(_) => vec![],
        None => mass_lines(moving, oscillator)?.into_iter().take(1).collect(),
    };
    lines.extend(energy.period(oscillator)?);
    solution.derivation = mass_lines(moving, oscillator)?;
    solution.derivation.extend(lines.iter().skip(usize::from(moving.mass.is_none())).cloned());
    solution.law = Law::Quadrature(lines);
    solution.validity.push(Note::Exact(ExactBy::EnergyQuadrature));
    Ok(solution)
}

fn energy_balance(
    moving: &VariableMass,
    oscillator: &Oscillator,
    options: &Options,
) -> Result<Solution, Refusal> {
    const METHOD: Method = Method::EnergyBalance;
    first_order_only(options, METHOD)?;
    require_odd(oscillator, &moving.force, METHOD)?;
    require_odd(oscillator, &moving.growth, METHOD)?;
    let mut solution = unsolved(oscillator, options, METHOD, 1);
    let x = oscillator.coordinate;
    let amplitude = Expr::symbol("A");
    let eighth = Expr::divide(&amplitude, &Expr::from(2).sqrt()?)?;
    let squared = Expr::symbol("omega").integer_power(2)?;
    let quarter = Expr::divide(&amplitude.integer_power(2)?, &Expr::from(4))?;
    solution.derivation = mass_lines(moving, oscillator)?;
    let law = || {
        let (mass, weighted) = (moving.mass.as_ref()?, moving.weighted_force()?);
        // A difference of other potentials loses its digits at small amplitudes: the work is
        // integrated instead.
        weighted.to_polynomial(&mut |_| None).ok()??;
        let potential = potential(&weighted, x)?;
        let at = |function: &Expr, place: &Expr| {
            let value = function.substitute(x, place).ok()?;
            positive_amplitude(&value).unwrap_or(value).expand().ok()
        };
        let rise = (at(&potential, &amplitude)? - at(&potential, &eighth)?).expand().ok()?;
        let inertia = at(mass, &eighth)?;
        let law = Expr::divide(&rise, &(&quarter * &inertia)).ok()?;
        let law = law.expand().ok().filter(|law| law.terms().len() < 2).unwrap_or(law);
        Some((rise, inertia, law))
    };
    match law() {
        Some((rise, inertia, law)) => {
            let kinetic = &quarter * &squared * &inertia;
            solution.derivation.push(
                DerivationLine::equation(kinetic, rise)
                    .because(format!("the energy of {AMPLITUDE}*cos(θ) at θ = pi/4")),
            );
            solution.derivation.push(DerivationLine::equation(squared, &law));
            set_law(&mut solution, &law)?;
        }
        None => {
            let (name, there) = (mass_name(oscillator), named("M_eighth", oscillator));
            let weighted = moving.weighted_force();
            let weighted = weighted.unwrap_or_else(|| Expr::from(name) * &moving.force);
            let mass = match &moving.mass {
                Some(mass) => mass.substitute(x, &eighth)?,
                None => there.into(),
            };
            let words = match &moving.mass {
                Some(_) => format!("the energy of {AMPLITUDE}*cos(θ) at θ = pi/4"),
                None => format!(
                    "the energy of {AMPLITUDE}*cos(θ) at θ = pi/4, {there} the value of {name} there"
                ),
            };
            let work = DerivationFormula::Integral {
                factor: Expr::one(),
                from: eighth,
                to: amplitude,
                integrand: Box::new(weighted.into()),
                variable: x,
            };
            let line = DerivationLine::equation(quarter * squared * mass, work).because(words);
            solution.derivation.push(line);
            solution.law = Law::Quadrature(solution.derivation.clone());
        }
    }
    solution.validity.push(Note::Collocated(CollocationInstant::EighthOfPeriod));
    Ok(solution)
}

fn hamiltonian(
    moving: &VariableMass,
    oscillator: &Oscillator,
    options: &Options,
) -> Result<Solution, Refusal> {
    const METHOD: Method = Method::Hamiltonian;
    first_order_only(options, METHOD)?;
    let mut solution = unsolved(oscillator, options, METHOD, 1);
    let x = oscillator.coordinate;
    let amplitude = Expr::symbol("A");
    let squared = Expr::symbol("omega").integer_power(2)?;
    solution.derivation = mass_lines(moving, oscillator)?;
    let law = || {
        let (mass, weighted) = (moving.mass.as_ref()?, moving.weighted_force()?);
        let half = Expr::number(ratio(1, 2));
        let mean = |function: &Expr| {
            let twice = cosine_coefficient(&function.expand().ok()?, x, &amplitude, 0)?;
            (twice * &half).expand().ok()
        };
        let rest = amplitude.integer_power(2).ok()? - Expr::from(x).integer_power(2).ok()?;
        let kinetic = mean(&(mass * &rest * &half))?;
        let potential = mean(&potential(&weighted, x)?)?;
        // Both slopes are odd in A: the common factor A is divided out.
        let slope = |of: &Expr| {
            Expr::divide(&of.differentiate("A".into()).ok()?, &amplitude).ok()?.expand().ok()
        };
        let law = Expr::divide(&slope(&potential)?, &slope(&kinetic)?).ok()?;
        Some((kinetic, potential, law))
    };
    match law() {
        Some((kinetic, potential, law)) => {
            let [k, p] = ["K", "P"].map(|name| named(name, oscillator));
            let slope =
                |of: Symbol, factor: Expr| DerivationFormula::Slope { factor, of, by: "A".into() };
            solution.derivation.extend([
                DerivationLine::equation(k, kinetic).because(format!(
                    "mean kinetic energy of {AMPLITUDE}*cos(θ) over {FREQUENCY}^2"
                )),
                DerivationLine::equation(p, potential).because("mean potential energy"),
                DerivationLine::equal([slope(k, squared.clone()), slope(p, Expr::one())])
                    .because(format!("stationary in {AMPLITUDE}")),
                DerivationLine::equation(squared, &law),
            ]);
            set_law(&mut solution, &law)?;
        }
        None => {
            let (cosine, sine) =
                (Expr::from(oscillator.phase()).cos()?, Expr::from(oscillator.phase()).sin()?);
            let along = &amplitude * &cosine;
            let mass = match &moving.mass {
                Some(mass) => mass.substitute(x, &along)?,
                None => mass_name(oscillator).into(),
            };
            let (growth, force) =
                (moving.growth.substitute(x, &along)?, moving.force.substitute(x, &along)?);
            let over_half = |factor: Expr, integrand: Expr| DerivationFormula::Integral {
                factor,
                from: Expr::zero(),
                to: Expr::pi(),
                integrand: Box::new(integrand.into()),
                variable: oscillator.phase(),
            };
            let bracket = &amplitude * &cosine.integer_power(2)?
                - amplitude.integer_power(2)? * growth * sine.integer_power(2)? * &cosine;
            let line = DerivationLine::equal([
                over_half(squared, &mass * &bracket),
                over_half(Expr::one(), mass * force * cosine),
            ]);
            solution.derivation.push(line.because(format!(
                "{} times the equation has no cos(θ) along {AMPLITUDE}*cos(θ)",
                mass_name(oscillator)
            )));
            solution.law = Law::Quadrature(solution.derivation.clone());
        }
    }
    solution.validity.push(Note::FirstStep(ExactFirstStep::TermOfEquation));
    Ok(solution)
}

/// The powers of `x`, `x'` and `x''` in a term, and the rest of it.
type TypedTerm = ([u32; 3], Polynomial);

/// The terms of the equation as typed, where it is a polynomial in `x`, `x'` and `x''`.
fn typed_terms(oscillator: &Oscillator) -> Result<Option<Vec<TypedTerm>>, Refusal> {
    let own = [oscillator.coordinate, oscillator.velocity(), oscillator.velocity().derivative()];
    let Some(polynomial) = oscillator.residual.expand()?.to_polynomial(&mut |_| None)? else {
        return Ok(None);
    };
    let term = |(monomial, number): (&crate::exact::polynomial::Monomial, &Rational)| {
        let mut powers = [0; 3];
        for (power, &name) in powers.iter_mut().zip(&own) {
            *power = u32::try_from(monomial.exponent(name)).ok()?;
        }
        let rest = own.iter().fold(monomial.clone(), |rest, &name| rest.without(name));
        Some((powers, Polynomial::term(rest, number.clone())))
    };
    Ok(polynomial.terms().map(term).collect())
}

fn harmonic_balance(
    moving: &VariableMass,
    oscillator: &Oscillator,
    options: &Options,
) -> Result<Solution, Refusal> {
    const METHOD: Method = Method::HarmonicBalance;
    /// The most harmonics of an equation with inertia terms.
    const HIGHEST: u32 = 40;
    let order = options.order.unwrap_or(2);
    if order == 0 || order > HIGHEST {
        return Err(Reason::HighestOrder(HIGHEST).to(METHOD));
    }
    let x = oscillator.coordinate;
    let odd = moving.is_odd(oscillator)?;
    let harmonics = harmonics(order, odd);
    let mut solution = unsolved(oscillator, options, METHOD, order);
    let names = match harmonics.as_slice() {
        [1] => vec![Symbol::new("A")],
        _ => coefficient_names(oscillator, &harmonics),
    };
    let mut cosine = vec![Polynomial::zero(); harmonics.last().map_or(0, |last| last + 1)];
    for (&k, &name) in harmonics.iter().zip(&names) {
        cosine[k] = Polynomial::symbol(name);
    }
    solution.displacement = FourierSeries::from_parts(POLYNOMIALS, cosine, vec![]);
    let typed = DerivationLine::equal([(&oscillator.residual).into(), Expr::zero().into()]);
    solution.derivation = vec![
        typed.because("balanced as it stands"),
        DerivationLine::equation(x, solution.displacement.clone()),
    ];
    match (balances(oscillator, &solution.displacement, &harmonics)?, names.as_slice()) {
        (Some(balances), [_]) => one_balance(&mut solution, &balances[0])?,
        (Some(balances), names) => solution.law = Law::System(system(&balances, names)?),
        (None, names) => {
            let projections = projections(oscillator, &harmonics, names)?;
            solution.derivation.extend(projections);
            solution.law = Law::Quadrature(solution.derivation.clone());
        }
    }
    solution.validity.push(Note::Balanced { harmonics, by_numbers: false });
    Ok(solution)
}

/// The cosine parts of the equation as typed along a motion with unknown coefficients, one for each
/// harmonic; `None` if it is not a polynomial, or too long to be written out.
fn balances(
    oscillator: &Oscillator,
    motion: &FourierSeries<Polynomials>,
    harmonics: &[usize],
) -> Result<Option<Vec<Polynomial>>, Refusal> {
    /// The longest system that is written out, in harmonics.
    const WRITTEN_OUT: usize = 6;
    let Some(terms) = typed_terms(oscillator)?.filter(|_| harmonics.len() <= WRITTEN_OUT) else {
        return Ok(None);
    };
    let omega = FourierSeries::constant(POLYNOMIALS, Polynomial::symbol("omega".into()));
    let velocity = motion.derivative().product(&omega);
    let acceleration = velocity.derivative().product(&omega);
    let factors = [motion, &velocity, &acceleration];
    let mut along = FourierSeries::zero(POLYNOMIALS);
    for (powers, coefficient) in &terms {
        let mut product = FourierSeries::constant(POLYNOMIALS, coefficient.clone());
        for (factor, &power) in factors.iter().zip(powers) {
            if power > 0 {
                product = product.product(&factor.power(power));
            }
        }
        along = along.sum(&product);
    }
    let balance = |&k: &usize| along.cosine(k).constant_term();
    Ok(Some(harmonics.iter().map(balance).collect()))
}

/// The law of one harmonic: its balance solved for omega^2.
fn one_balance(solution: &mut Solution, balance: &Polynomial) -> Result<(), Refusal> {
    let squared = Expr::symbol("omega").integer_power(2)?;
    let balance = Expr::from(balance);
    let still = balance.substitute("omega".into(), &Expr::zero())?;
    let inertia = Expr::divide(&(&still - &balance).expand()?, &squared)?.expand()?;
    let amplitude = Expr::symbol("A");
    let law = Expr::divide(
        &Expr::divide(&still, &amplitude)?.expand()?,
        &Expr::divide(&inertia, &amplitude)?.expand()?,
    )?;
    let condition = DerivationLine::equation(balance, Expr::zero()).because("the cos(θ) part");
    solution.derivation.extend([condition, DerivationLine::equation(squared, &law)]);
    set_law(solution, &law)
}

/// The balances of several harmonics, whose coefficients add up to the amplitude.
fn system(balances: &[Polynomial], names: &[Symbol]) -> Result<AlgebraicSystem, Refusal> {
    let sum = Expr::sum(names.iter().map(|name| Expr::from(*name)));
    let mut equations: Vec<Expr> = balances.iter().map(Expr::from).collect();
    equations.push((sum - Expr::symbol("A")).expand()?);
    let omega = std::iter::once(Symbol::new("omega"));
    Ok(AlgebraicSystem { unknowns: omega.chain(names.iter().copied()).collect(), equations })
}

/// The balances as integrals, where they are not written out.
fn projections(
    oscillator: &Oscillator,
    harmonics: &[usize],
    names: &[Symbol],
) -> Result<Vec<DerivationLine>, Refusal> {
    let kept: Vec<String> = harmonics.iter().map(ToString::to_string).collect();
    let k = named("k", oscillator);
    let projection = DerivationFormula::Integral {
        factor: Expr::one(),
        from: Expr::zero(),
        to: Expr::pi(),
        integrand: Box::new(
            (&oscillator.residual * &(Expr::from(k) * Expr::from(oscillator.phase())).cos()?)
                .into(),
        ),
        variable: oscillator.phase(),
    };
    let line = DerivationLine::equal([projection, Expr::zero().into()]);
    let mut lines = vec![line.because(format!("for {k} = {}", kept.join(", ")))];
    if names.len() > 1 {
        let sum = Expr::sum(names.iter().map(|name| Expr::from(*name)));
        lines.push(DerivationLine::equation("A", sum));
    }
    Ok(lines)
}

/// omega^2 and the motion of an answer for such an equation at numbers, the equilibrium left out;
/// `None` if the law is explicit, or if there is no such solution.
pub(super) fn at_numbers(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<AtNumbers> {
    // The coordinate is measured from the equilibrium, as in the formulas.
    let equilibrium = solution.equilibrium.clone();
    let moved = &Expr::from(oscillator.coordinate) + &equilibrium;
    let mut centred = oscillator.clone();
    centred.force = oscillator.force.substitute(oscillator.coordinate, &moved).ok()?;
    centred.residual = oscillator.residual.substitute(oscillator.coordinate, &moved).ok()?;
    let oscillator = &centred;
    let moving = VariableMass::from_oscillator(oscillator).ok()??;
    let amplitude = *numbers.get(&solution.amplitude.symbol())?;
    let mass = moving.mass_at(oscillator, numbers, amplitude)?;
    let force =
        CentredForce::new(&moving.force, oscillator.coordinate, &Expr::zero(), numbers, amplitude)?;
    let approach = MethodEntry::for_method(solution.method).inertia.as_ref()?;
    (approach.numbers)(&EquationAtNumbers {
        moving: &moving,
        oscillator,
        order: solution.order,
        numbers,
        amplitude,
        mass: &mass,
        force: &force,
    })
}

/// An equation at numbers, in the distance from its equilibrium.
struct EquationAtNumbers<'a> {
    moving: &'a VariableMass,
    oscillator: &'a Oscillator,
    order: u32,
    numbers: &'a BTreeMap<Symbol, f64>,
    amplitude: f64,
    mass: &'a dyn Fn(f64) -> f64,
    force: &'a CentredForce,
}

impl EquationAtNumbers<'_> {
    /// The slope of the potential.
    fn weighted(&self, x: f64) -> f64 {
        (self.mass)(x) * self.force.value(x)
    }

    fn one_term(&self, squared: f64) -> Option<AtNumbers> {
        let motion = FourierSeries::from_parts(Doubles, vec![0.0, self.amplitude], vec![]);
        squared.is_finite().then_some((squared, motion))
    }
}

fn exact_at(question: &EquationAtNumbers) -> Option<AtNumbers> {
    let (mass, weighted) = (question.mass, |x| question.weighted(x));
    let force = energy::PiecewiseForce::smooth(&weighted);
    let (period, cosine) =
        weighted_motion(&force, &|x| mass(x).sqrt(), 0.0, question.amplitude).ok()?;
    let frequency = std::f64::consts::TAU / period;
    let motion = FourierSeries::from_parts(Doubles, cosine, vec![]);
    Some((frequency * frequency, motion))
}

fn energy_balance_at(question: &EquationAtNumbers) -> Option<AtNumbers> {
    let amplitude = question.amplitude;
    let eighth = amplitude / f64::sqrt(2.0);
    let rise = integrate_smooth(|x| question.weighted(x), eighth, amplitude, 1e-12).ok()?.0;
    question.one_term(4.0 * rise / (amplitude * amplitude * (question.mass)(eighth)))
}

fn hamiltonian_at(question: &EquationAtNumbers) -> Option<AtNumbers> {
    let amplitude = question.amplitude;
    let growth = compiled(question.oscillator, &question.moving.growth, question.numbers)?;
    let mean = |function: &dyn Fn(f64, f64) -> f64| {
        let value = |theta: f64| function(theta.cos(), theta.sin());
        integrate_smooth(value, 0.0, std::f64::consts::PI, 1e-12).map(|(value, _)| value)
    };
    let inertia = mean(&|c, s| {
        let x = amplitude * c;
        (question.mass)(x) * (c * c - amplitude * growth(x) * s * s * c)
    });
    let work = mean(&|c, _| question.weighted(amplitude * c) * c);
    question.one_term(work.ok()? / (amplitude * inertia.ok()?))
}

fn harmonic_balance_at(question: &EquationAtNumbers) -> Option<AtNumbers> {
    let odd = question.moving.is_odd(question.oscillator).ok()?;
    let harmonics = harmonics(question.order, odd);
    balanced(question.oscillator, question.numbers, &harmonics, question.amplitude)
}

/// The balance of the equation as typed by Newton's iteration, the amplitude raised in steps from a
/// nearly linear one.
fn balanced(
    oscillator: &Oscillator,
    numbers: &BTreeMap<Symbol, f64>,
    harmonics: &[usize],
    amplitude: f64,
) -> Option<AtNumbers> {
    const FEWEST_STEPS: i32 = 16;
    const SMALLEST_STEP: f64 = 1e-4;
    let first = harmonics.iter().position(|&k| k == 1)?;
    let balance = SampledResidual::new(oscillator, numbers, harmonics)?;
    let (mut part, mut step) = (0.0, 1.0 / f64::from(FEWEST_STEPS));
    let mut unknowns = DVector::zeros(harmonics.len() + 1);
    unknowns[0] = balance.linear()?;
    while part < 1.0 {
        let next = f64::min(part + step, 1.0);
        let mut start = unknowns.clone();
        if part == 0.0 {
            start[first + 1] = next * amplitude;
        } else {
            start *= next / part;
            start[0] = unknowns[0];
        }
        let found = balance.newton(start, next * amplitude);
        match found.filter(|found| found[0] > 0.0 && (found[0] / unknowns[0]).ln().abs() < 0.3) {
            Some(found) => {
                (unknowns, part) = (found, next);
                step = f64::min(2.0 * step, 1.0 / f64::from(FEWEST_STEPS));
            }
            None => step *= 0.5,
        }
        if step < SMALLEST_STEP {
            return None;
        }
    }
    let mut cosine = vec![0.0; harmonics.last()? + 1];
    for (index, &k) in harmonics.iter().enumerate() {
        cosine[k] = unknowns[index + 1];
    }
    Some((unknowns[0], FourierSeries::from_parts(Doubles, cosine, vec![])))
}

/// The equation as typed and its slopes in `x`, `x'` and `x''`, sampled along a motion.
struct SampledResidual {
    /// The residual, then its three slopes.
    functions: Vec<CompiledFunction>,
    arguments: Vec<f64>,
    harmonics: Vec<usize>,
    points: usize,
}

impl SampledResidual {
    fn new(
        oscillator: &Oscillator,
        numbers: &BTreeMap<Symbol, f64>,
        harmonics: &[usize],
    ) -> Option<Self> {
        const FEWEST: usize = 128;
        let own =
            [oscillator.coordinate, oscillator.velocity(), oscillator.velocity().derivative()];
        let names: Vec<Symbol> = own.into_iter().chain(numbers.keys().copied()).collect();
        let slopes = own.iter().map(|&name| oscillator.residual.differentiate(name).ok());
        let expressions: Vec<Expr> = std::iter::once(Some(oscillator.residual.clone()))
            .chain(slopes)
            .collect::<Option<_>>()?;
        let functions =
            expressions.iter().map(|expression| CompiledFunction::new(expression, &names).ok());
        Some(Self {
            functions: functions.collect::<Option<_>>()?,
            arguments: [0.0; 3].into_iter().chain(numbers.values().copied()).collect(),
            harmonics: harmonics.to_vec(),
            points: FEWEST.max(16 * (harmonics.last()? + 1)),
        })
    }

    /// Residual and slopes at a state.
    fn evaluate(&self, state: [f64; 3]) -> Vec<f64> {
        let mut arguments = self.arguments.clone();
        arguments[..3].copy_from_slice(&state);
        self.functions.iter().map(|function| function.call(&arguments)).collect()
    }

    /// omega0^2 at rest.
    fn linear(&self) -> Option<f64> {
        let at_rest = self.evaluate([0.0; 3]);
        let squared = at_rest[1] / at_rest[3];
        (squared > 0.0 && squared.is_finite()).then_some(squared)
    }

    /// The solution `[omega^2, a_k...]` near a start.
    fn newton(&self, start: DVector<f64>, amplitude: f64) -> Option<DVector<f64>> {
        const ITERATIONS: usize = 40;
        let count = self.harmonics.len();
        let equations = |unknowns: &DVector<f64>| {
            let squared = unknowns[0];
            let omega = squared.sqrt();
            let mut residual = DVector::zeros(count + 1);
            let mut jacobian = DMatrix::zeros(count + 1, count + 1);
            for point in 0..self.points {
                let theta = std::f64::consts::PI * (point as f64 + 0.5) / self.points as f64;
                let waves: Vec<(f64, f64, f64)> = self
                    .harmonics
                    .iter()
                    .map(|&k| (k as f64, (k as f64 * theta).cos(), (k as f64 * theta).sin()))
                    .collect();
                let (mut x, mut slope, mut bend) = (0.0, 0.0, 0.0);
                for (&coefficient, (k, cosine, sine)) in unknowns.iter().skip(1).zip(&waves) {
                    x += coefficient * cosine;
                    slope -= coefficient * k * sine;
                    bend -= coefficient * k * k * cosine;
                }
                let values = self.evaluate([x, omega * slope, squared * bend]);
                let by_frequency = values[2] * slope / (2.0 * omega) + values[3] * bend;
                for (row, wave) in waves.iter().enumerate() {
                    residual[row] += values[0] * wave.1;
                    jacobian[(row, 0)] += by_frequency * wave.1;
                    for (column, (k, cosine, sine)) in waves.iter().enumerate() {
                        let change = values[1] * cosine
                            - values[2] * omega * k * sine
                            - values[3] * squared * k * k * cosine;
                        jacobian[(row, column + 1)] += change * wave.1;
                    }
                }
            }
            residual[count] = unknowns.rows(1, count).sum() - amplitude;
            for column in 0..count {
                jacobian[(count, column + 1)] = 1.0;
            }
            Some((residual, jacobian))
        };
        let judged = |unknowns: &DVector<f64>, change: &DVector<f64>| {
            if !unknowns.iter().all(|value| value.is_finite()) || unknowns[0] <= 0.0 {
                return Progress::Lost;
            }
            let scale = unknowns.rows(1, count).amax();
            match change[0].abs() <= 1e-12 * unknowns[0]
                && change.rows(1, count).amax() <= 1e-12 * scale
            {
                true => Progress::Settled,
                false => Progress::Going,
            }
        };
        newton(start, ITERATIONS, equations, judged)
    }
}

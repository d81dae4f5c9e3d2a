//! The potential of a force in closed form.
//!
//! Reference: L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., section 11.
//!
//! ```text
//! V' = f:   x^n -> x^(n+1)/(n+1),   1/x -> log|x|,   sin(kx + p) -> -cos(kx + p)/k,   exp -> exp/k,   tan -> -log(cos)/k
//! (kx + p)^n H(kx + p) -> (kx + p)^(n+1) H(kx + p)/(k (n+1)),   x/(a + b x^2) -> log(a + b x^2)/(2 b)
//! log u -> u log(u)/k - x,   atan u -> (u atan u - log(1 + u^2)/2)/k,   1/u -> log(u)/k      with u = kx + p
//! h(g(x)) g'(x) -> W(g(x)),  W' = h:   sin(x) cos(x), x exp(x^2), tanh(x)/cosh(x)^2
//! ```
//!
//! The constant of integration is left as it comes: formulas take differences.

use num_traits::{One, Signed, ToPrimitive, Zero};

use super::{linear_in, split, take_powers, with_steps};
use crate::exact::Rational;
use crate::exact::rational::ratio;
use crate::expr::{Expr, Function, Node};
use crate::symbol::{Symbol, fresh};

/// An antiderivative of a force in `coordinate`; `None` if a term has no closed form here.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::{method::potential, expr::Expr};
/// let force: Expr = "sin(x) + eps*x^3".parse().unwrap();
/// assert_eq!(potential(&force, "x".into()).unwrap().to_string(), "eps*x^4/4 - cos(x)");
/// ```
pub fn potential(force: &Expr, coordinate: Symbol) -> Option<Expr> {
    let terms = |force: &Expr| -> Option<Expr> {
        let parts = force.terms().iter().map(|term| of_term(term, coordinate));
        Some(Expr::sum(parts.collect::<Option<Vec<_>>>()?))
    };
    // The force is first tried as it was typed, so that (x - xc)^(3/2)*H(x - xc) and 1/(1 + x^2)
    // stay together, then in expanded form.
    let force = with_steps(force, coordinate).ok()?;
    terms(&force).or_else(|| terms(&force.expand().ok()?))
}

fn of_term(term: &Expr, coordinate: Symbol) -> Option<Expr> {
    at_sight(term, coordinate).or_else(|| by_substitution(term, coordinate))
}

/// `h(g(x)) g'(x)`, whose integral is that of `h` at `g`, for one of the functions that the term is
/// made of as `g`.
fn by_substitution(term: &Expr, coordinate: Symbol) -> Option<Expr> {
    /// Largest number of candidates that are tried.
    const CANDIDATES: usize = 8;
    let (outside, inside) = split(term, coordinate);
    let integrand = Expr::product(inside);
    let square = Expr::from(coordinate).integer_power(2).ok()?;
    let parts = integrand.unique_nodes().filter_map(|node| match node.node() {
        // A whole power of one is tried by its base.
        Node::Sum(_) => Some(node.clone()),
        Node::Function(function, _)
            if !matches!(function, Function::Absolute | Function::Sign | Function::Step) =>
        {
            Some(node.clone())
        }
        _ => None,
    });
    let parts = parts.filter(|part| *part != integrand && part.contains(coordinate));
    let names: Vec<Symbol> = term.symbols().into_iter().collect();
    let variable = fresh("y", &names);
    let value = |part: Expr| -> Option<Expr> {
        let slope = part.differentiate(coordinate).ok()?;
        if slope.is_zero() {
            return None;
        }
        let by_part =
            in_terms_of(&part, variable, &Expr::divide(&integrand, &slope).ok()?, coordinate)?;
        let terms = by_part.expand().ok()?;
        let terms = terms
            .terms()
            .iter()
            .map(|term| power_of(term, variable).or_else(|| at_sight(term, variable)));
        let value = Expr::sum(terms.collect::<Option<Vec<_>>>()?);
        value.substitute(variable, &part).ok()
    };
    let found = std::iter::once(square).chain(parts).take(CANDIDATES).find_map(value)?;
    has_logarithms_at_rest(&found, coordinate).then(|| outside * found)
}

/// An antiderivative of `c u^n`, valid where `u` is positive or the power has a value.
fn power_of(term: &Expr, variable: Symbol) -> Option<Expr> {
    let (outside, inside) = split(term, variable);
    let [factor] = inside.as_slice() else {
        return None;
    };
    let (base, exponent) = factor.base_and_exponent();
    let next = Expr::number(exponent.as_number()? + Rational::one());
    if base.as_symbol() != Some(variable) {
        return None;
    }
    let value = match next.is_zero() {
        true => Expr::function(Function::Log, vec![base]),
        false => Expr::power(&base, &next).and_then(|power| Expr::divide(&power, &next)),
    };
    Some(outside * value.ok()?)
}

/// An expression written in `variable = part`; `None` if something of the coordinate is left.
fn in_terms_of(part: &Expr, variable: Symbol, of: &Expr, coordinate: Symbol) -> Option<Expr> {
    let name = Expr::from(variable);
    let even_power = |expr: &Expr| {
        let (base, exponent) = expr.base_and_exponent();
        let half = exponent.as_number()? / Rational::from_integer(2.into());
        let is_square = base.as_symbol() == Some(coordinate) && half.is_integer();
        is_square.then_some(half)
    };
    let squared = even_power(part).is_some_and(|half| half.is_one());
    let written = of.fold(|expr, children: &[Expr]| match even_power(expr) {
        _ if expr == part => Ok(name.clone()),
        Some(half) if squared => Expr::power(&name, &Expr::number(half)),
        _ => expr.with_children(children),
    });
    written.ok().filter(|written| !written.contains(coordinate))
}

/// Whether the argument of every logarithm is positive at rest, as far as numbers tell.
fn has_logarithms_at_rest(expr: &Expr, coordinate: Symbol) -> bool {
    expr.unique_nodes().all(|node| match node.node() {
        Node::Function(Function::Log, arguments) => arguments.iter().all(|argument| {
            let at_rest = argument.substitute(coordinate, &Expr::zero());
            at_rest.is_ok_and(|value| value.as_number().is_none_or(Signed::is_positive))
        }),
        _ => true,
    })
}

fn at_sight(term: &Expr, coordinate: Symbol) -> Option<Expr> {
    let (outside, mut inside) = split(term, coordinate);
    let x = Expr::from(coordinate);
    if inside.is_empty() {
        return Some(&outside * &x);
    }
    if let Some(value) = shifted_power(&inside, coordinate) {
        return Some(outside * value);
    }
    let mut coefficient = Expr::one();
    let power = take_powers(&mut inside, &mut coefficient, coordinate)?;
    let outside = outside * coefficient;
    let next = &power.exponent + Rational::one();
    let whole = power.exponent.is_integer();
    let value = match inside.as_slice() {
        // The antiderivative log|x| of 1/x serves on both sides of the pole; that of 1/|x| would
        // jump there.
        [] if next.is_zero() && power.odd => {
            let size = Expr::function(Function::Absolute, vec![x]).ok()?;
            Expr::function(Function::Log, vec![size]).ok()?
        }
        [] if next.is_zero() => return None,
        [] => {
            // |x|^(n+1)/(n+1), with the sign where the force is even.
            let odd_after = !power.odd;
            let size = if whole && (odd_after == next.numer().is_odd()) {
                Expr::power(&x, &Expr::number(next.clone())).ok()?
            } else {
                let size = Expr::function(Function::Absolute, vec![x.clone()]).ok()?;
                let size = Expr::power(&size, &Expr::number(next.clone())).ok()?;
                match odd_after {
                    true => size * Expr::function(Function::Sign, vec![x]).ok()?,
                    false => size,
                }
            };
            Expr::divide(&size, &Expr::number(next)).ok()?
        }
        [factor] => {
            let exponent = power
                .exponent
                .to_integer()
                .to_u32()
                .filter(|_| whole && power.odd == power.exponent.numer().is_odd())?;
            with_power(factor, exponent, coordinate)?
        }
        _ => return None,
    };
    Some(outside * value)
}

/// `u^n`, `u^n H(u)` and `H(u)` for linear `u`.
fn shifted_power(factors: &[Expr], coordinate: Symbol) -> Option<Expr> {
    let (mut base, mut exponent, mut step) = (None, Rational::zero(), None);
    for factor in factors {
        let (inside, power) = factor.base_and_exponent();
        match inside.node() {
            Node::Function(Function::Step, arguments) if step.is_none() => {
                step = arguments.first().cloned()
            }
            Node::Sum(_) if base.is_none() => {
                exponent = power.as_number()?.clone();
                base = Some(inside);
            }
            _ => return None,
        }
    }
    let argument = step.clone().or_else(|| base.clone())?;
    let (slope, _) = linear_in(&argument, coordinate)?;
    let base = base.unwrap_or_else(|| argument.clone());
    let (base_slope, _) = linear_in(&base, coordinate)?;
    if let Some(step) = &step {
        // The step must turn where the base vanishes.
        let proportional = (&(step * &base_slope) - &(&base * &slope)).expand().ok()?;
        if !proportional.is_zero() {
            return None;
        }
    }
    let next = exponent + Rational::one();
    if next.is_zero() {
        // The side of the pole on which the equilibrium lies.
        let at_rest = base.substitute(coordinate, &Expr::zero()).ok()?;
        let size = match at_rest.as_number() {
            Some(number) if number.is_positive() => base,
            Some(number) if number.is_negative() => -base,
            _ => Expr::function(Function::Absolute, vec![base]).ok()?,
        };
        let logarithm = Expr::function(Function::Log, vec![size]).ok()?;
        return step.is_none().then(|| Expr::divide(&logarithm, &base_slope).ok())?;
    }
    let value = Expr::divide(
        &Expr::power(&base, &Expr::number(next.clone())).ok()?,
        &(base_slope * Expr::number(next)),
    )
    .ok()?;
    match step {
        Some(step) => Some(value * Expr::function(Function::Step, vec![step]).ok()?),
        None => Some(value),
    }
}

/// `x^n` times one other factor.
fn with_power(factor: &Expr, exponent: u32, coordinate: Symbol) -> Option<Expr> {
    let (base, power) = factor.base_and_exponent();
    let power = power.as_number()?.clone();
    let call = |function, argument: &Expr| Expr::function(function, vec![argument.clone()]).ok();
    match base.node() {
        Node::Function(function, arguments) => {
            let argument = arguments.first()?;
            let (slope, constant) = linear_in(argument, coordinate)?;
            let divided = |value: Expr| Expr::divide(&value, &slope).ok();
            let x = Expr::from(coordinate);
            match function {
                // x^n H(k x + p): equal to (x^(n+1) - edge^(n+1)) H/(n + 1).
                Function::Step if power.is_one() => {
                    let edge = Expr::divide(&-constant, &slope).ok()?;
                    let next = i64::from(exponent) + 1;
                    let rise = x.integer_power(next).ok()? - edge.integer_power(next).ok()?;
                    let step = call(Function::Step, argument)?;
                    Some(rise * step * Expr::number(ratio(1, next)))
                }
                // By parts, once for each power of x: int x^n g = x^n G - n int x^(n-1) G.
                Function::Sin | Function::Cos | Function::Sinh | Function::Cosh | Function::Exp => {
                    let start = match (function, power.to_integer().to_i64()?) {
                        (Function::Exp, _) => {
                            let argument = argument * &Expr::number(power);
                            let value = call(Function::Exp, &argument)?;
                            return exponential_by_parts(
                                &value,
                                &linear_in(&argument, coordinate)?.0,
                                exponent,
                                &x,
                            );
                        }
                        (_, 1) => *function,
                        (Function::Sin | Function::Cos, 2) if exponent == 0 => {
                            // (x -+ sin u cos u/k)/2
                            let product = divided(
                                call(Function::Sin, argument)? * call(Function::Cos, argument)?,
                            )?;
                            let sum =
                                if *function == Function::Sin { x - product } else { x + product };
                            return Some(sum * Expr::number(ratio(1, 2)));
                        }
                        _ => return None,
                    };
                    wave_by_parts(start, argument, &slope, exponent, &x)
                }
                Function::Tan if power.is_one() && exponent == 0 => {
                    divided(-call(Function::Log, &call(Function::Cos, argument)?)?)
                }
                Function::Tanh if power.is_one() && exponent == 0 => {
                    divided(call(Function::Log, &call(Function::Cosh, argument)?)?)
                }
                Function::Log if power.is_one() && exponent == 0 => {
                    Some(divided(argument * &base)? - x)
                }
                Function::Atan if power.is_one() && exponent == 0 => {
                    let circle = Expr::one() + argument.integer_power(2).ok()?;
                    let logarithm = call(Function::Log, &circle.expand().ok()?)?;
                    divided(argument * &base - logarithm * Expr::number(ratio(1, 2)))
                }
                _ => None,
            }
        }
        Node::Sum(_) => quadratic_power(&base, &power, exponent, coordinate),
        _ => None,
    }
}

fn exponential_by_parts(value: &Expr, slope: &Expr, exponent: u32, x: &Expr) -> Option<Expr> {
    let mut terms = Vec::new();
    let mut factor = Expr::divide(value, slope).ok()?;
    for power in (0..=i64::from(exponent)).rev() {
        let x_power = if power == 0 { Expr::one() } else { x.integer_power(power).ok()? };
        terms.push(&factor * &x_power);
        factor = -Expr::divide(&(factor * Expr::from(power)), slope).ok()?;
    }
    Some(Expr::sum(terms))
}

fn wave_by_parts(
    function: Function,
    argument: &Expr,
    slope: &Expr,
    exponent: u32,
    x: &Expr,
) -> Option<Expr> {
    let mut terms = Vec::new();
    let (mut function, mut factor) = (function, Expr::one());
    for power in (0..=i64::from(exponent)).rev() {
        // The integral of the wave, and its sign.
        let (next, sign) = match function {
            Function::Sin => (Function::Cos, -1),
            Function::Cos => (Function::Sin, 1),
            Function::Sinh => (Function::Cosh, 1),
            Function::Cosh => (Function::Sinh, 1),
            _ => return None,
        };
        factor = Expr::divide(&(factor * Expr::from(sign)), slope).ok()?;
        let x_power = if power == 0 { Expr::one() } else { x.integer_power(power).ok()? };
        terms.push(&factor * &x_power * Expr::function(next, vec![argument.clone()]).ok()?);
        factor = -(factor * Expr::from(power));
        function = next;
    }
    Some(Expr::sum(terms))
}

/// `x^n (a + b x^2)^p` for odd `n`, by `y = x^2`: `int y^m (a + b y)^p dy/2`.
fn quadratic_power(
    base: &Expr,
    power: &Rational,
    exponent: u32,
    coordinate: Symbol,
) -> Option<Expr> {
    if exponent.is_multiple_of(2) {
        return None;
    }
    let square = Expr::from(coordinate).integer_power(2).ok()?;
    let a = base.substitute(coordinate, &Expr::zero()).ok()?;
    let b = Expr::divide(&(base - &a).expand().ok()?, &square).ok()?.expand().ok()?;
    if b.is_zero() || b.contains(coordinate) {
        return None;
    }
    // y = (u - a)/b: int ((u - a)/b)^m u^p du/(2 b)
    let m = (exponent - 1) / 2;
    let mut binomial = Rational::one();
    let mut terms = Vec::new();
    for i in 0..=m {
        let next = power + Rational::from_integer((i64::from(i) + 1).into());
        let grown = if next.is_zero() {
            Expr::function(Function::Log, vec![base.clone()]).ok()?
        } else {
            Expr::divide(&Expr::power(base, &Expr::number(next.clone())).ok()?, &Expr::number(next))
                .ok()?
        };
        let rest = match m - i {
            0 => Expr::one(),
            left => (-&a).integer_power(i64::from(left)).ok()?,
        };
        terms.push(grown * rest * Expr::number(binomial.clone()));
        binomial = binomial * Rational::from_integer((m - i).into())
            / Rational::from_integer((i + 1).into());
    }
    let below = Expr::from(2) * b.integer_power(i64::from(m) + 1).ok()?;
    Expr::divide(&Expr::sum(terms), &below).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::CompiledFunction;
    use crate::numeric::ode::quadrature::integrate_smooth;

    #[test]
    fn differences_of_the_potential_are_the_work_of_the_force() {
        for text in [
            "x + 3*x^3 - x^4/7 + 2",
            "sin(2*x + 1) - cos(x)",
            "x^3*sin(x) - x^2*cosh(x/2)",
            "x^2*exp(-x/3)",
            "exp(-x) - exp(-2*x)",
            "sin(x)*cos(x)",
            "sin(x)^2",
            "tan(x/3) + tanh(x)",
            "x*abs(x) - sgn(x)",
            "abs(x)^(3/2)",
            "x + 2/x",
            "x^(1/3) + x^(2/3)",
            "(x - 1/2)^(3/2)*H(x - 1/2)",
            "(x - 1/2)*H(x - 1/2) + x^2*H(1/3 - x)",
            "abs(x - 1/2)",
            "x/(1 + x^2)",
            "x^3/(1 + x^2)",
            "x/sqrt(1 + 2*x^2) - x^3*(1 + x^2)^(3/2)",
            "sin(x)^3*cos(x) - sin(x)*cos(x)^2",
            "x*exp(-x^2) + x^3*exp(x^2/2)",
            "x*sin(x^2) + x^5*cos(x^2)",
            "tanh(x)/cosh(x)^2 + sinh(x)*cosh(x)",
            "(1 + 2*x)*(x + x^2 + 7)^(1/2)",
            "log(3 + 2*x)*5 + atan(x/2 + 1)",
            "1/(3 + x) - 1/(x - 2) + exp(x)/(1 + exp(x))",
            "atan(x)/(1 + x^2) + x/(2 - x^2)*log(2 + 1/3)",
        ] {
            let force: Expr = text.parse().unwrap();
            let potential =
                potential(&force, "x".into()).unwrap_or_else(|| panic!("no potential of {text}"));
            let [force, potential] =
                [&force, &potential].map(|e| CompiledFunction::new(e, &["x".into()]).unwrap());
            for (from, to) in [(0.6, 1.3), (0.05, 0.3), (-1.2, -0.4)] {
                let work = integrate_smooth(|x| force.call(&[x]), from, to, 1e-13).unwrap().0;
                let rise = potential.call(&[to]) - potential.call(&[from]);
                assert!(
                    (work - rise).abs() < 1e-12 * (1.0 + work.abs()),
                    "{text} {from} {to}: {work} {rise}"
                );
            }
        }
    }

    #[test]
    fn what_has_none_is_none() {
        for text in [
            "sin(x^2)",
            "exp(x^2)",
            "x*tan(x)",
            "1/abs(x)",
            "exp(x)*sin(x)",
            "x*sqrt(1 + x^2 + x^4)",
            "(x - 1/2)^(3/2)*H(x - 1/3)",
        ] {
            assert_eq!(potential(&text.parse().unwrap(), "x".into()), None, "{text}");
        }
    }
}

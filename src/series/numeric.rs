//! Taylor coefficients as floating-point numbers: what exact ones would take too long for, or cannot be because the point of
//! expansion is no fraction.
//!
//! Reference: E. Hairer, S. P. Norsett, G. Wanner, *Solving Ordinary Differential Equations I*, 2nd ed., section I.8
//! (recurrences for powers and elementary functions). With `u = u_0 + u_1 s + ...`:
//!
//! ```text
//! p = u^a:      n u_0 p_n = sum_(k=1..n) (a k - n + k) u_k p_(n-k)
//! e = exp u:    n e_n = sum_(k=1..n) k u_k e_(n-k)
//! l = log u:    n u_0 l_n = n u_n - sum_(k=1..n-1) k l_k u_(n-k)
//! s, c = sin u, cos u:   n s_n = sum k u_k c_(n-k),   n c_n = -sum k u_k s_(n-k)
//! y with y' = u' g:      n y_n = sum k u_k g_(n-k)    (asin, acos, atan)
//! ```

use num_traits::ToPrimitive;

use crate::exact::rational::to_f64;
use crate::expr::{Expr, Function, Node};
use crate::symbol::Symbol;

/// The coefficients of `s^0` to `s^degree` of an expression with `coordinate = centre + scale*s` and no other symbol; `None`
/// where it is not analytic there, contains another symbol, or a coefficient is out of range.
pub fn numeric_taylor(expr: &Expr, coordinate: Symbol, centre: f64, scale: f64, degree: usize) -> Option<Vec<f64>> {
    let length = degree + 1;
    let constant = |value: f64| {
        let mut series = vec![0.0; length];
        series[0] = value;
        series
    };
    let result = expr.fold(|expr, children: &[Vec<f64>]| {
        let series = match (expr.node(), children) {
            (Node::Number(value), _) => constant(to_f64(value)),
            (Node::Pi, _) => constant(std::f64::consts::PI),
            (Node::Symbol(symbol), _) if *symbol == coordinate => {
                let mut series = constant(centre);
                if degree > 0 {
                    series[1] = scale;
                }
                series
            }
            (Node::Symbol(_), _) => return Err(()),
            (Node::Sum(_), terms) => terms.iter().fold(constant(0.0), |mut sum, term| {
                sum.iter_mut().zip(term).for_each(|(sum, value)| *sum += value);
                sum
            }),
            (Node::Product(coefficient, _), factors) => {
                factors.iter().fold(constant(to_f64(coefficient)), |product, factor| {
                    multiply(&product, factor)
                })
            }
            (Node::Power(_, exponent), [base, exponent_series]) => match exponent.as_number() {
                Some(exponent) if exponent.is_integer() => {
                    whole_power(base, exponent.to_integer().to_i64().ok_or(())?).ok_or(())?
                }
                Some(exponent) => power(base, to_f64(exponent)).ok_or(())?,
                None => exponential(&multiply(exponent_series, &logarithm(base).ok_or(())?)),
            },
            (Node::Function(function, _), arguments) => of_function(*function, arguments).ok_or(())?,
            _ => return Err(()),
        };
        match series.iter().all(|value| value.is_finite()) {
            true => Ok(series),
            false => Err(()),
        }
    });
    result.ok()
}

fn multiply(left: &[f64], right: &[f64]) -> Vec<f64> {
    (0..left.len())
        .map(|n| (0..=n).map(|k| left[k] * right[n - k]).sum())
        .collect()
}

/// `n y_n = sum_(k=1..n) k u_k g_(n-k)`: the series with `y' = u' g` and this first coefficient.
fn integrate_along(u: &[f64], g: &[f64], first: f64) -> Vec<f64> {
    let term = |n: usize| (1..=n).map(|k| k as f64 * u[k] * g[n - k]).sum::<f64>() / n as f64;
    (0..u.len()).map(|n| if n == 0 { first } else { term(n) }).collect()
}

fn exponential(u: &[f64]) -> Vec<f64> {
    let mut e = vec![u[0].exp()];
    for n in 1..u.len() {
        e.push((1..=n).map(|k| k as f64 * u[k] * e[n - k]).sum::<f64>() / n as f64);
    }
    e
}

fn logarithm(u: &[f64]) -> Option<Vec<f64>> {
    if u[0] <= 0.0 {
        return None;
    }
    let mut l: Vec<f64> = vec![u[0].ln()];
    for n in 1..u.len() {
        let lower: f64 = (1..n).map(|k| k as f64 * l[k] * u[n - k]).sum();
        l.push((n as f64 * u[n] - lower) / (n as f64 * u[0]));
    }
    Some(l)
}

/// Powers of a series that does not vanish at the centre.
fn power(u: &[f64], exponent: f64) -> Option<Vec<f64>> {
    let whole = exponent == exponent.trunc();
    if u[0] == 0.0 || (u[0] < 0.0 && !whole) {
        return None;
    }
    let mut p = vec![u[0].powf(exponent)];
    for n in 1..u.len() {
        let sum: f64 = (1..=n)
            .map(|k| (exponent * k as f64 - (n - k) as f64) * u[k] * p[n - k])
            .sum();
        p.push(sum / (n as f64 * u[0]));
    }
    Some(p)
}

fn whole_power(u: &[f64], exponent: i64) -> Option<Vec<f64>> {
    if u[0] != 0.0 {
        return power(u, exponent as f64);
    }
    if exponent < 0 {
        return None;
    }
    let mut one = vec![0.0; u.len()];
    one[0] = 1.0;
    // Beyond the degree nothing is left.
    let times = usize::try_from(exponent).ok()?.min(u.len());
    Some((0..times).fold(one, |product, _| multiply(&product, u)))
}

/// The pair of sine and cosine, or of their hyperbolic sisters.
fn waves(u: &[f64], hyperbolic: bool) -> (Vec<f64>, Vec<f64>) {
    let sign = if hyperbolic { 1.0 } else { -1.0 };
    let (mut sine, mut cosine) = match hyperbolic {
        true => (vec![u[0].sinh()], vec![u[0].cosh()]),
        false => (vec![u[0].sin()], vec![u[0].cos()]),
    };
    for n in 1..u.len() {
        let of = |other: &[f64]| (1..=n).map(|k| k as f64 * u[k] * other[n - k]).sum::<f64>() / n as f64;
        let (next_sine, next_cosine) = (of(&cosine), sign * of(&sine));
        sine.push(next_sine);
        cosine.push(next_cosine);
    }
    (sine, cosine)
}

fn of_function(function: Function, arguments: &[Vec<f64>]) -> Option<Vec<f64>> {
    let negative = |series: &[f64]| series.iter().map(|value| -value).collect::<Vec<f64>>();
    let constant = |value: f64, length: usize| {
        let mut series = vec![0.0; length];
        series[0] = value;
        series
    };
    // 1 + sign*u^2
    let one_and_square = |u: &[f64], sign: f64| {
        let mut series: Vec<f64> = multiply(u, u).iter().map(|value| sign * value).collect();
        series[0] += 1.0;
        series
    };
    let (u, v) = match arguments {
        [u] => (u, u),
        [u, v] => (u, v),
        _ => return None,
    };
    Some(match function {
        Function::Sin => waves(u, false).0,
        Function::Cos => waves(u, false).1,
        Function::Sinh => waves(u, true).0,
        Function::Cosh => waves(u, true).1,
        Function::Tan | Function::Tanh => {
            let (sine, cosine) = waves(u, function == Function::Tanh);
            multiply(&sine, &power(&cosine, -1.0)?)
        }
        Function::Exp => exponential(u),
        Function::Log => logarithm(u)?,
        Function::Atan => integrate_along(u, &power(&one_and_square(u, 1.0), -1.0)?, u[0].atan()),
        Function::Asin => integrate_along(u, &power(&one_and_square(u, -1.0), -0.5)?, u[0].asin()),
        Function::Acos => {
            let mut series = negative(&integrate_along(u, &power(&one_and_square(u, -1.0), -0.5)?, 0.0));
            series[0] = u[0].acos();
            series
        }
        // Away from their corners these are one smooth piece.
        Function::Absolute if u[0] != 0.0 => match u[0] > 0.0 {
            true => u.clone(),
            false => negative(u),
        },
        Function::Sign if u[0] != 0.0 => constant(u[0].signum(), u.len()),
        Function::Step if u[0] != 0.0 => constant(if u[0] > 0.0 { 1.0 } else { 0.0 }, u.len()),
        Function::Maximum if u[0] != v[0] => if u[0] > v[0] { u } else { v }.clone(),
        Function::Minimum if u[0] != v[0] => if u[0] < v[0] { u } else { v }.clone(),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{CompiledFunction, parse_expression};

    #[test]
    fn the_series_is_the_function() {
        let x: Symbol = "x".into();
        let texts = [
            "x^3 - 2*x + 1/x^2",
            "sin(x)*cos(2*x) + tan(x)",
            "sinh(x) - cosh(x)*tanh(x)",
            "exp(-x^2) + log(1 + x)*sqrt(2 + x)",
            "asin(x/3) + acos(x/4)*atan(x)",
            "abs(x - 3) + sgn(x)*max(x, x^2/100) + min(x, 7) + H(x)*x",
            "(1 + x)^x + x^(7/3) + asin(sin(x))",
        ];
        for text in texts {
            let expression = parse_expression(text).unwrap();
            let function = CompiledFunction::new(&expression, &[x]).unwrap();
            let series = numeric_taylor(&expression, x, 0.7, 0.1, 40).unwrap();
            for s in [-0.5_f64, 0.3, 0.9] {
                let sum = series.iter().rev().fold(0.0, |sum, c| sum * s + c);
                let exact = function.call(&[0.7 + 0.1 * s]);
                assert!(
                    (sum - exact).abs() < 1e-13 * (1.0 + exact.abs()),
                    "{text} at {s}: {sum} {exact}"
                );
            }
        }
        for text in ["abs(x)", "x^(1/3)", "log(x)", "1/x", "k*x"] {
            assert_eq!(
                numeric_taylor(&parse_expression(text).unwrap(), x, 0.0, 1.0, 4),
                None,
                "{text}"
            );
        }
    }
}

//! Motions with velocities in the force: limit cycles, and inertia that depends on the position.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lindstedt::Values;
use lindstedt::method::{Options, solve};
use lindstedt::solution::Method;
use lindstedt::verify::{judge, motions};
use lindstedt::{Oscillator, Solution, Symbol};

use super::families::number;
use super::quadrature::{bisect, integrate};
use crate::random::Random;

/// One period of `x'' = acceleration(x, x')` between two maxima, and the maximum, after the
/// transient has gone.
fn cycle(
    acceleration: &dyn Fn(f64, f64) -> f64,
    start: f64,
    step: f64,
    transient: f64,
) -> Option<(f64, f64)> {
    let rule = |x: f64, v: f64, h: f64| {
        let (x1, v1) = (v, acceleration(x, v));
        let (x2, v2) = (v + 0.5 * h * v1, acceleration(x + 0.5 * h * x1, v + 0.5 * h * v1));
        let (x3, v3) = (v + 0.5 * h * v2, acceleration(x + 0.5 * h * x2, v + 0.5 * h * v2));
        let (x4, v4) = (v + h * v3, acceleration(x + h * x3, v + h * v3));
        (
            x + h / 6.0 * (x1 + 2.0 * x2 + 2.0 * x3 + x4),
            v + h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4),
        )
    };
    let (mut x, mut v, mut t) = (start, 0.0, 0.0);
    let mut maximum: Option<f64> = None;
    while t < transient + 200.0 {
        let (next_x, next_v) = rule(x, v, step);
        if !next_x.is_finite() {
            return None;
        }
        if v > 0.0 && next_v <= 0.0 && t > transient {
            // The fraction of the step at which the velocity is zero.
            let part = bisect(&|part| rule(x, v, part * step).1, 0.0, 1.0);
            let now = t + part * step;
            match maximum {
                Some(before) => return Some((now - before, rule(x, v, part * step).0)),
                None => maximum = Some(now),
            }
        }
        (x, v, t) = (next_x, next_v, t + step);
    }
    None
}

/// `x'' - mu (1 - b x^2 - c x^4) x' + k x = 0`: the cycle's amplitude to first order from the
/// balance of energy, its true frequency by a long run, and the exponent with which the error of
/// the series vanishes.
pub fn limit_cycle(random: &mut Random) -> (String, Option<String>) {
    let b = number(random.between(0.3, 3.0));
    let c = number(random.between(0.1, 2.0));
    let quartic = random.percent(30.0);
    let mu = number(random.between(0.02, 1.5));
    let fourth = if quartic { format!(" - {}*x^4", c.text()) } else { String::new() };
    let text = format!("x'' - mu*(1 - {}*x^2{fourth})*x' + x = 0", b.text());
    let described = format!("\"{text}\" --at mu={}", mu.text());
    let oscillator = match Oscillator::parse(&text) {
        Ok(oscillator) => oscillator,
        Err(error) => return (described, Some(format!("refused: {error}"))),
    };
    let fourth = if quartic { c.value() } else { 0.0 };
    let loss = |x: f64| 1.0 - b.value() * x * x - fourth * x.powi(4);
    // No energy in the mean over a cosine: int (1 - b x^2 - ...) sin^2 = 0.
    let mean = |a: f64| {
        let power = |theta: f64| loss(a * theta.cos()) * theta.sin().powi(2);
        integrate(&power, &[0.0, FRAC_PI_2, PI], 1e-13).unwrap_or(f64::NAN)
    };
    let first = bisect(&mean, 1e-3, 20.0);
    let options = Options { order: Some(2), ..Options::default() };
    let solution = match solve(&oscillator, &options) {
        Ok(solution) => solution,
        Err(refusal) => return (described, Some(format!("refused: {refusal}"))),
    };
    let at = |mu: f64| move |symbol: Symbol| (symbol == Symbol::new("mu")).then_some(mu);
    let amplitude = solution
        .limit_cycle
        .as_ref()
        .and_then(|law| solution.evaluate(&law.amplitude, &at(0.0)).ok());
    match amplitude {
        Some(found) if (found / first - 1.0).abs() < 1e-10 => {}
        found => {
            return (
                described,
                Some(format!("amplitude {found:?}, but the energy is balanced at {first}")),
            );
        }
    }
    // A long run on the other side of time where the cycle repels.
    let transient = (60.0 / mu.value()).clamp(60.0, 3000.0);
    let acceleration = |x: f64, v: f64| mu.value() * loss(x) * v - x;
    let Some((period, _)) = cycle(&acceleration, 0.9 * first, 1e-3 * 5.0, transient) else {
        return (described, None);
    };
    let mut values = Values::default();
    values.insert("mu".into(), mu.text().parse().expect("a number")).expect("one value");
    let complaint = match judge(&oscillator, &solution, &values, 0.01) {
        Err(error) => Some(format!("the cycle is not found: {error}")),
        Ok(judged) => {
            let expected = TAU / period;
            let wrong = (judged.true_frequency / expected - 1.0).abs() > 1e-7;
            wrong.then(|| format!("true omega = {}, not {expected}", judged.true_frequency))
        }
    };
    (described, complaint)
}

/// `(1 + c x^2) x'' + c x x'^2 + k x + b x^3 = 0`, whose energy is
/// `(1 + c x^2) x'^2/2 + k x^2/2 + b x^4/4`.
pub fn inertia(random: &mut Random) -> (String, Option<String>) {
    let (c, k) = (number(random.between(0.1, 3.0)), number(random.between(0.2, 5.0)));
    let b = number(random.between(0.1, 3.0));
    let cubic = random.percent(50.0);
    let b_value = if cubic { b.value() } else { 0.0 };
    let amplitude = number(random.between(0.05, 1.5));
    let third = if cubic { format!(" + {}*x^3", b.text()) } else { String::new() };
    let text =
        format!("(1 + {c}*x^2)*x'' + {c}*x*x'^2 + {k}*x{third} = 0", c = c.text(), k = k.text());
    let described = format!("\"{text}\" --at A={}", amplitude.text());
    let true_frequency = |a: f64| {
        // x = a sin(phi): V(a) - V(x) = a^2 cos^2 (k + b a^2 (1 + sin^2)/2)/2
        let time = |phi: f64| {
            let square = (a * phi.sin()).powi(2);
            ((1.0 + c.value() * square) / (k.value() + 0.5 * b_value * (a * a + square))).sqrt()
        };
        integrate(&time, &[0.0, FRAC_PI_2], 1e-14).map(|quarter| FRAC_PI_2 / quarter)
    };
    let found = || -> Result<(f64, f64), String> {
        let oscillator = Oscillator::parse(&text).map_err(|error| error.to_string())?;
        let options = Options { order: Some(4), ..Options::default() };
        let solution = solve(&oscillator, &options).map_err(|error| error.to_string())?;
        let mut values = Values::default();
        values.insert("A".into(), amplitude.text().parse().expect("a number")).expect("one value");
        // A law that is negative at this amplitude has no motion to judge: the true one beside the
        // exact law is the same.
        let at_amplitude =
            |symbol: Symbol| (symbol == Symbol::new("A")).then_some(amplitude.value());
        let squared = solution.frequency_squared_at(&at_amplitude).ok_or("no law")?;
        let judged = |solution: &Solution| {
            motions(&oscillator, solution, &values).map_err(|error| error.to_string())
        };
        let motions = match (judged(&solution)?, squared > 0.0) {
            (Some(motions), true) => motions,
            (None, false) => {
                let options = Options { method: Some(Method::Exact), ..Options::default() };
                let exact = solve(&oscillator, &options).map_err(|error| error.to_string())?;
                judged(&exact)?.ok_or("the exact omega is not real")?
            }
            (motions, _) => {
                return Err(format!("motion: {}, omega^2 = {squared}", motions.is_some()));
            }
        };
        let period = motions.truth.last().ok_or("no motion")?.0;
        // The error of a series through A^4 vanishes like A^6.
        let error = |a: f64| {
            let at = |symbol: Symbol| (symbol == Symbol::new("A")).then_some(a);
            let squared = solution.frequency_squared_at(&at)?;
            Some((squared.sqrt() / true_frequency(a)? - 1.0).abs())
        };
        let size = 0.3 / (c.value() + b_value / k.value()).sqrt();
        let slope = (error(size).ok_or("no law")? / error(0.5 * size).ok_or("no law")?).log2();
        Ok((TAU / period, slope))
    };
    let complaint = match found() {
        Err(error) => Some(format!("refused: {error}")),
        Ok((frequency, slope)) => {
            let expected = true_frequency(amplitude.value()).expect("a smooth integral");
            if (frequency / expected - 1.0).abs() > 1e-9 {
                Some(format!("true omega = {frequency}, not {expected}"))
            } else {
                (slope < 5.5)
                    .then(|| format!("the error of order 4 vanishes like A^{slope:.2}, not A^6"))
            }
        }
    };
    (described, complaint)
}

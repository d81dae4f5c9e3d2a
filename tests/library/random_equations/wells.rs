//! Where the motion of a random equation ends, and its series: the separatrix and the radius of
//! convergence, both known from how the equation was made.
//!
//! ```text
//! f = k x (1 + x/a) (1 - x/b) (1 + c x^2)    rims at -a and b; over the lower one the motion leaves on both sides
//! f = k (sin(c x) - sin(u))                  equilibrium u/c, rims at (pi - u)/c and (-pi - u)/c
//! f = k x/(1 - x/p)^2                        the force ends at p
//! k x + c x^(2 n + 1), k x + c x^3 + d x^5   the nearest zero of f(A)/A in the complex plane
//! k x + b x^2                                A = k/(2 |b|), from which the motion runs into the zero on the other side
//! k sin(c x)                                 pi/c
//! (1 - 2 s cos(u)/R + (s/R)^2)^(-e)          s = R exp(+-i u)
//! ```

use std::collections::BTreeMap;
use std::f64::consts::PI;

use lindstedt::Values;
use lindstedt::expr::Expr;
use lindstedt::method::CentredForce;
use lindstedt::method::{Options, solve};
use lindstedt::solution::Method;
use lindstedt::verify::judge;
use lindstedt::verify::nearest_singularity;
use lindstedt::verify::{Well, WellEnd};
use lindstedt::{Oscillator, Symbol};

use super::quadrature::bisect;
use crate::random::Random;

/// Equations of each kind.
const EACH: u64 = 12;

/// The amplitudes at which the well ends on either side, asked from an amplitude inside.
fn ends(text: &str, equilibrium: &str, amplitude: f64) -> Option<[Option<WellEnd>; 2]> {
    let [force, equilibrium]: [Expr; 2] =
        [text, equilibrium].map(|text| text.parse().expect("an expression"));
    let force = CentredForce::new(&force, "x".into(), &equilibrium, &BTreeMap::new(), amplitude)
        .expect("a force");
    let well = Well::new(&force, amplitude)?;
    Some([well.low, well.high])
}

/// A well whose potential above its bottom is `rise`, between rims at these distances: where
/// motions end on either side.
fn truth(rise: &dyn Fn(f64) -> f64, low: f64, high: f64) -> [f64; 2] {
    let (left, right) = (rise(low), rise(high));
    match left < right {
        true => [low, bisect(&|x| rise(x) - left, 0.0, high)],
        false => [-bisect(&|x| rise(-x) - right, 0.0, -low), high],
    }
}

fn hold(text: &str, equilibrium: &str, expected: [f64; 2], random: &mut Random) {
    for side in 0..2 {
        let amplitude = expected[side] * random.between(0.01, 0.99);
        let found = ends(text, equilibrium, amplitude)
            .unwrap_or_else(|| panic!("{text}: no end from {amplitude:e}"));
        for (found, expected) in found.iter().zip(expected) {
            let found = found.map_or(f64::INFINITY, |end| end.amplitude);
            assert!(
                (found / expected - 1.0).abs() < 1e-6,
                "{text} about {equilibrium} from {amplitude:e}: {found:e}, not {expected:e}"
            );
        }
    }
}

#[test]
fn separatrices_are_where_the_equation_was_made_to_have_them() {
    for seed in 0..EACH {
        let random = &mut Random::new(seed);
        let (unit, k) = (10.0_f64.powi(random.whole(-12, 12) as i32), random.between(1e-16, 1e16));
        let [a, b] = [0, 1].map(|_| unit * random.between(0.3, 3.0));
        let c = random.choose(&[0.0, 1.0]) * random.between(0.1, 10.0) / (unit * unit);
        let text = format!("{k:e}*x*(1 + x/{a:e})*(1 - x/{b:e})*(1 + {c:e}*x^2)");
        let text = match random.percent(50.0) {
            true => text,
            false => {
                let force: Expr = text.parse().expect("a force");
                force.expand().expect("short").to_string()
            }
        };
        // Of x (1 + p x - q x^2)(1 + c x^2), p = 1/a - 1/b, q = 1/(a b).
        let (p, q) = (1.0 / a - 1.0 / b, 1.0 / (a * b));
        let rise = |x: f64| {
            let powers = [1.0, p, c - q, c * p, -c * q];
            let terms = powers
                .iter()
                .enumerate()
                .map(|(n, value)| value * x.powi(n as i32) / (n as f64 + 2.0));
            terms.sum::<f64>() * x * x
        };
        hold(&text, "0", truth(&rise, -a, b), random);

        let (c, u) = (random.between(0.1, 10.0) / unit, random.between(0.05, 1.2));
        let rise = |y: f64| u.cos() - (u + c * y).cos() - u.sin() * c * y;
        let rims = [-(PI + 2.0 * u) / c, (PI - 2.0 * u) / c];
        hold(
            &format!("{k:e}*(sin({c:e}*x) - sin({u:e}))"),
            &format!("{u:e}/{c:e}"),
            truth(&rise, rims[0], rims[1]),
            random,
        );

        let side = random.choose(&[-1.0, 1.0]);
        let pole = side * unit * random.between(0.3, 3.0);
        let found =
            ends(&format!("{k:e}*x/(1 - x/({pole:e}))^2"), "0", 0.4 * pole).expect("an end");
        let [low, high] = if side > 0.0 { found } else { [found[1], found[0]] };
        let end = high.expect("an end");
        assert!(low.is_none() && !end.rim.separatrix, "{pole:e}: {low:?}");
        assert!((end.amplitude / pole - 1.0).abs() < 1e-6, "{end:?}, not {pole:e}");
    }
}

/// The radius and, where it is said, the angle of the nearest singularity in `A` or `A^2`.
fn stated(equation: &str, amplitude: f64) -> Option<(f64, f64)> {
    let oscillator = Oscillator::parse(equation).expect(equation);
    let options =
        Options { method: Some(Method::LindstedtPoincare), order: Some(2), ..Options::default() };
    let solution = solve(&oscillator, &options).expect(equation);
    let mut at = Values::default();
    let value = format!("{amplitude:e}").parse().expect("a number");
    at.insert(Symbol::new("A"), value).expect("a value");
    let verification = judge(&oscillator, &solution, &at, 0.01)
        .unwrap_or_else(|error| panic!("{equation}: {error}"));
    let text = verification
        .ranges
        .iter()
        .find_map(|range| range.text.strip_prefix("the series converges for |A| < about "))?;
    let radius = text.split(':').next()?.parse().ok()?;
    let place = text.rsplit(" = ").next()?;
    let angle = match place.split_once(" e^(+-") {
        Some((_, angle)) => angle.trim_end_matches("i)").parse().ok()?,
        None if place.starts_with('-') => PI,
        None => 0.0,
    };
    Some((radius, angle))
}

#[test]
fn radii_of_convergence_are_where_the_equation_was_made_to_have_them() {
    let mut said = [0; 5];
    for seed in 0..EACH {
        let random = &mut Random::new(1000 + seed);
        let (unit, k) = (10.0_f64.powi(random.whole(-12, 12) as i32), random.between(1e-16, 1e16));
        let sign = random.choose(&[-1.0, 1.0]);
        let size = random.between(0.1, 10.0);
        let (c, n) = (sign * k * size, random.whole(1, 3) as i32);
        let of_sign = if sign < 0.0 { 0.0 } else { PI };
        let zero = unit * size.powf(-0.5 / f64::from(n));
        // k + c u + d u^2 = 0 at a pair of places.
        let (d, turn) = (random.between(0.1, 10.0), random.between(0.3, 2.8));
        let pair = -2.0 * turn.cos() * d.sqrt();
        let wave = random.between(0.1, 10.0) / unit;
        let power = |n: i32| unit.powi(-n);
        let cases = [
            (format!("{k:e}*x + {:e}*x^3", c * power(2)), unit / size.sqrt(), Some(of_sign)),
            (format!("{k:e}*x + {:e}*x^{}", c * power(2 * n), 2 * n + 1), zero, None),
            (
                format!("{k:e}*x + {:e}*x^3 + {:e}*x^5", k * pair * power(2), k * d * power(4)),
                unit * d.powf(-0.25),
                Some(turn),
            ),
            (format!("{k:e}*x + {:e}*x^2", c * power(1)), unit / (2.0 * size), None),
            (format!("{k:e}*sin({wave:e}*x)"), PI / wave, Some(0.0)),
        ];
        for (number, (force, radius, angle)) in cases.into_iter().enumerate() {
            // Well inside every well.
            let equation = format!("x'' + {} = 0", force.replace("+ -", "- "));
            let Some(found) = stated(&equation, 0.1 * radius) else {
                continue;
            };
            said[number] += 1;
            assert!(
                (found.0 / radius - 1.0).abs() < 0.02,
                "{equation}: {}, not {radius:e}",
                found.0
            );
            if let Some(angle) = angle {
                assert!((found.1 - angle).abs() < 0.05, "{equation}: {}, not {angle}", found.1);
            }
        }
    }
    // Where nothing can be told nothing is said, but not everywhere.
    assert!(said[0] == EACH && said[3] == EACH && said[4] == EACH, "{said:?}");
    assert!(said[1] >= EACH / 4 && said[2] >= EACH / 4, "{said:?}");
}

#[test]
fn known_singularities_are_read_off_their_series() {
    let mut said = 0;
    for seed in 0..200 {
        let random = &mut Random::new(2000 + seed);
        // Two dozen coefficients tell a pair from a single place where it turns by more than pi/24
        // from one to the next.
        let between = random.whole(150, 2990) as f64 / 1000.0;
        let angle = random.choose(&[0.0, PI, between, between]);
        let radius = random.between(1e-3, 1e3);
        let exponent = random.choose(&[0.5, 1.0, -0.25, 1.5, 2.0]);
        // Gegenbauer's polynomials: k C_k = 2 (k + e - 1) cos(u) C_(k-1) - (k + 2 e - 2) C_(k-2).
        let mut series = vec![1.0, 2.0 * exponent * angle.cos()];
        for k in 2..26 {
            let k = f64::from(k);
            let [before, last] = [series[series.len() - 2], series[series.len() - 1]];
            series.push(
                (2.0 * (k + exponent - 1.0) * angle.cos() * last
                    - (k + 2.0 * exponent - 2.0) * before)
                    / k,
            );
        }
        // Something that is regular up to three times as far, and another unit.
        let far = radius.recip() / 3.0;
        let factor = |k: usize| far.powi(k as i32);
        let scaled = |k: usize| series[k] / radius.powi(k as i32);
        let product: Vec<f64> =
            (0..series.len()).map(|k| (0..=k).map(|j| scaled(j) * factor(k - j)).sum()).collect();
        let Some(found) = nearest_singularity(&product) else {
            continue;
        };
        said += 1;
        assert!(
            (found.radius / radius - 1.0).abs() < 0.02 && (found.angle - angle).abs() < 0.05,
            "{seed}: {found:?}, not {radius} at {angle} ({exponent})"
        );
    }
    assert!(said > 120, "{said}");
}

//! The work that the fastest programs for perturbation series are measured by, printed line by line
//! so that theirs can be compared: `workloads W1 40`. W1 Duffing, W2 the pendulum, W3 van der Pol,
//! W4 three symbolic coefficients, each to an order; W7a, W7b, W7c many motions of an equation of one's
//! own, free, with a contact, and at every period of a drive. `T` is the time of the calculation alone,
//! in seconds.

use std::error::Error;
use std::time::Instant;

use lindstedt::exact::{Integer, Integers, Polynomial, Polynomials, Rational, factorial};
use lindstedt::expr::parse_expression;
use lindstedt::method::secular::{
    AmplitudeKind, Detuning, ExpansionScope, ForceTerm, Scheme, SecularExpansion, expand_numbers,
    expand_polynomials,
};
use lindstedt::series::{FourierSeries, fraction};
use lindstedt::solution::AmplitudeConvention;
use lindstedt::trajectory::{PoincareSection, TrajectoryRequest, sweep};
use lindstedt::{Oscillator, Symbol};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [work, order] = arguments.as_slice() else {
        return Err("usage: workloads W1|W2|W3|W4 ORDER, or W7a|W7b|W7c MOTIONS".into());
    };
    let order: usize = order.parse()?;
    match work.as_str() {
        "W1" => conservative(&[term(1, 3, 0, Rational::from_integer(1.into()))], order),
        "W2" => conservative(&sine(order), order),
        "W3" => van_der_pol(order),
        "W4" => symbolic(order),
        "W7a" => swings("x'' + 2*zeta*x' + sin(x) = 0", 1.5, order),
        "W7b" => swings("x'' + 2*zeta*x' + sin(x) + 1e4*max(x - 0.3, 0)^1.5 = 0", -1.5, order),
        "W7c" => driven(order),
        _ => Err(format!("no work {work}").into()),
    }
}

fn term(order: usize, position: u32, velocity: u32, coefficient: Rational) -> ForceTerm<Integers> {
    let numerator = FourierSeries::constant(Integers, coefficient.numer().clone());
    ForceTerm { order, position, velocity, coefficient: numerator.over(coefficient.denom()) }
}

/// `sin x - x` in powers of `A^2`.
fn sine(order: usize) -> Vec<ForceTerm<Integers>> {
    let coefficient = |n: usize| {
        let sign = if n.is_multiple_of(2) { 1 } else { -1 };
        Rational::new(Integer::from(sign), factorial(2 * n as u32 + 1))
    };
    (1..=order).map(|n| term(n, 2 * n as u32 + 1, 0, coefficient(n))).collect()
}

fn timed(
    force: &[ForceTerm<Integers>],
    order: usize,
    amplitude: AmplitudeKind,
) -> Result<SecularExpansion<Integers>, Box<dyn Error>> {
    let scheme = Scheme {
        normalisation: AmplitudeConvention::Initial,
        amplitude,
        detuning: Detuning::Acceleration,
    };
    let start = Instant::now();
    let expansion = expand_numbers(force, order, &scheme, ExpansionScope::Motion)?;
    println!("T {:.9}", start.elapsed().as_secs_f64());
    Ok(expansion)
}

fn conservative(force: &[ForceTerm<Integers>], order: usize) -> Result<(), Box<dyn Error>> {
    let expansion = timed(force, order, AmplitudeKind::Free)?;
    for (k, square) in expansion.frequency_squared.iter().enumerate() {
        println!("W {k} {}", mean(square));
    }
    for j in 0..=order {
        println!("F {j} {}", mean(&expansion.displacement[order].cosine(2 * j + 1)));
    }
    Ok(())
}

/// `x'' + eps (x^2 - 1) x' + x = 0` with `x = 2 y`.
fn van_der_pol(order: usize) -> Result<(), Box<dyn Error>> {
    let number = |value: i64| Rational::from_integer(value.into());
    let force = [term(1, 2, 1, number(4)), term(1, 0, 1, number(-1))];
    let expansion = timed(&force, order, AmplitudeKind::Determined)?;
    let twice = |series: &FourierSeries<Integers>| mean(&series.times(2));
    for k in 0..=order / 2 {
        println!("W {k} {}", mean(&expansion.frequency[2 * k]));
    }
    for k in (0..=order - 2).step_by(2) {
        println!("A {k} {}", twice(&expansion.displacement[k].at_zero()));
    }
    for j in 0..order {
        println!("F {j} {}", twice(&expansion.displacement[order - 1].sine(2 * j + 1)));
    }
    Ok(())
}

fn mean(constant: &FourierSeries<Integers>) -> Rational {
    let (numerator, denominator) = constant.mean();
    fraction(&numerator, denominator)
}

/// The frequency alone, as the program it is compared with.
fn symbolic(order: usize) -> Result<(), Box<dyn Error>> {
    let letters = ["a2", "a3", "a5"];
    let terms = [2, 3, 5].into_iter().zip(letters);
    let force: Vec<ForceTerm<Polynomials<Integers>>> = terms
        .map(|(position, name)| ForceTerm {
            order: 1,
            position,
            velocity: 0,
            coefficient: FourierSeries::constant(
                Polynomials(Integers),
                Polynomial::symbol(Symbol::new(name)),
            ),
        })
        .collect();
    let scheme = Scheme {
        normalisation: AmplitudeConvention::Initial,
        amplitude: AmplitudeKind::Free,
        detuning: Detuning::Acceleration,
    };
    let start = Instant::now();
    let expansion = expand_polynomials(&force, order, &scheme, ExpansionScope::Frequency)?;
    println!("T {:.9}", start.elapsed().as_secs_f64());
    for (n, square) in expansion.frequency_squared.iter().enumerate() {
        let (numerator, denominator) = square.mean();
        for (monomial, coefficient) in numerator.terms() {
            let [i, j, k] = letters.map(|name| monomial.exponent(Symbol::new(name)));
            println!("W {n} {i} {j} {k} {}", fraction(coefficient, denominator));
        }
    }
    Ok(())
}

/// Follows an equation to t = 50 for dampings from 0.01 to 0.2, as `lindstedt simulate EQUATION --sweep
/// zeta=0.01:0.2:MOTIONS` does.
fn swings(equation: &str, start: f64, motions: usize) -> Result<(), Box<dyn Error>> {
    let mut course = TrajectoryRequest::of_equation(&Oscillator::parse(equation)?);
    course.begin("x".into(), start)?;
    course.duration = 50.0;
    swept(&course, "zeta", [0.01, 0.2], motions)
}

/// The points of a bifurcation diagram, of two wells with a drive of 0.2 to 0.4 from t = 500 to 800.
fn driven(motions: usize) -> Result<(), Box<dyn Error>> {
    let equation = "x'' + 0.3*x' - x + x^3 = F*cos(1.2*t)";
    let mut course = TrajectoryRequest::of_equation(&Oscillator::parse(equation)?);
    course.begin("x".into(), 1.0)?;
    (course.duration, course.after) = (800.0, 500.0);
    course.section = Some(PoincareSection::Every(parse_expression("2*pi/1.2")?));
    swept(&course, "F", [0.2, 0.4], motions)
}

fn swept(
    course: &TrajectoryRequest,
    name: &str,
    [from, to]: [f64; 2],
    motions: usize,
) -> Result<(), Box<dyn Error>> {
    let step = (to - from) / motions.saturating_sub(1).max(1) as f64;
    let values: Vec<Vec<f64>> =
        (0..motions).map(|index| vec![from + step * index as f64]).collect();
    let start = Instant::now();
    let motions = sweep(course, &[name.into()], &values, || ()).map_err(|(_, error)| error)?;
    println!("T {:.9}", start.elapsed().as_secs_f64());
    for motion in motions {
        println!("R {} {:?} {}", motion.values[0], motion.state, motion.crossings.len());
    }
    Ok(())
}

//! Families of random forces.

use super::force::{Force, Number, Shape, Term};
use crate::random::Random;

/// Draws the terms of one force.
type Family = fn(&mut Random) -> Vec<Term>;

/// What kinds of force there are.
pub const FAMILIES: [(&str, Family); 15] = [
    ("odd polynomial", odd_polynomial),
    ("polynomial", polynomial),
    ("power alone", power_alone),
    ("fractional power", fractional_power),
    ("sine", sine),
    ("tanh, atan, sinh", saturating),
    ("exponential", exponential),
    ("rational", rational),
    ("rational with a pole", with_pole),
    ("barrier", barrier),
    ("bump", bump),
    ("static load", static_load),
    ("cosine load", cosine_load),
    ("several wells", several_wells),
    ("parameters", parameters),
];

/// What `LINDSTEDT_RANDOM_FAMILY` asks for.
pub fn asked_for() -> Option<String> {
    std::env::var("LINDSTEDT_RANDOM_FAMILY").ok()
}

/// One question: a family, a force and an amplitude, both without dimensions.
pub struct Case {
    pub family: &'static str,
    pub force: Force,
    pub amplitude: Number,
}

pub fn case(random: &mut Random) -> Case {
    let chosen = asked_for();
    let asked = |name: &str| chosen.as_ref().is_none_or(|part| name.contains(part));
    let asked: Vec<_> = FAMILIES.iter().copied().filter(|(name, _)| asked(name)).collect();
    let (family, terms) = random.choose(&asked);
    let terms = terms(random);
    let (length, rate) = if random.percent(50.0) {
        (0, 0)
    } else {
        // Lengths in steps of a million keep fractional powers of ten whole.
        (6 * random.whole(-2, 2) as i32, 2 * random.whole(-8, 8) as i32)
    };
    let wide = random.percent(30.0);
    let size = if wide { random.between(1e-8, 1e8) } else { random.between(0.03, 4.0) };
    let amplitude = number(if random.percent(30.0) { -size } else { size });
    Case { family, force: Force { terms, length, rate }, amplitude }
}

/// Three digits of a value.
pub fn number(value: f64) -> Number {
    let exponent = value.abs().log10().floor() as i32 - 2;
    let mut mantissa = (value / 10_f64.powi(exponent)).round() as i64;
    let mut exponent = exponent;
    while mantissa % 10 == 0 && mantissa != 0 {
        mantissa /= 10;
        exponent += 1;
    }
    Number::new(mantissa, exponent)
}

fn term(coefficient: Number, shape: Shape) -> Term {
    Term { coefficient, shape, name: None }
}

/// A coefficient of ordinary size, now and then a far smaller or larger one.
fn positive(random: &mut Random) -> Number {
    let wide = random.percent(15.0);
    let value = if wide { random.between(1e-4, 1e4) } else { random.between(0.2, 5.0) };
    number(value)
}

fn either(random: &mut Random) -> Number {
    let size = positive(random);
    Number::new(if random.percent(40.0) { -size.mantissa } else { size.mantissa }, size.exponent)
}

fn stiffness(random: &mut Random) -> Term {
    let one = random.percent(50.0);
    term(if one { Number::new(1, 0) } else { positive(random) }, Shape::Power(1))
}

fn odd_polynomial(random: &mut Random) -> Vec<Term> {
    let mut terms = vec![stiffness(random), term(either(random), Shape::Power(3))];
    for n in [5, 7] {
        if random.percent(35.0) {
            terms.push(term(either(random), Shape::Power(n)));
        }
    }
    terms
}

fn polynomial(random: &mut Random) -> Vec<Term> {
    let mut terms = vec![stiffness(random), term(either(random), Shape::Power(2))];
    for n in [3, 4, 5] {
        if random.percent(50.0) {
            terms.push(term(either(random), Shape::Power(n)));
        }
    }
    terms
}

fn power_alone(random: &mut Random) -> Vec<Term> {
    let mut terms = vec![term(positive(random), Shape::Power(3))];
    if random.percent(50.0) {
        terms.push(term(positive(random), Shape::Power(5)));
    }
    terms
}

fn fractional_power(random: &mut Random) -> Vec<Term> {
    let (p, q) = random.choose(&[(1, 3), (2, 1), (3, 2), (1, 2), (5, 3), (5, 2), (2, 3), (7, 3)]);
    let mut terms = vec![term(positive(random), Shape::SignedPower(p, q))];
    if random.percent(60.0) {
        terms.push(stiffness(random));
    }
    terms
}

fn sine(random: &mut Random) -> Vec<Term> {
    let b = if random.percent(50.0) { Number::new(1, 0) } else { positive(random) };
    let mut terms = vec![term(positive(random), Shape::Sine(b))];
    if random.percent(40.0) {
        terms.push(stiffness(random));
    }
    if random.percent(20.0) {
        terms.push(term(positive(random), Shape::Power(3)));
    }
    terms
}

fn saturating(random: &mut Random) -> Vec<Term> {
    let b = positive(random);
    let shape = random.choose(&[Shape::Tanh(b), Shape::Arctangent(b), Shape::Sinh(b)]);
    let mut terms = vec![term(positive(random), shape)];
    if random.percent(50.0) {
        terms.push(stiffness(random));
    }
    terms
}

fn exponential(random: &mut Random) -> Vec<Term> {
    let mut terms = vec![term(positive(random), Shape::Exponential(positive(random)))];
    if random.percent(30.0) {
        terms.push(stiffness(random));
    }
    terms
}

fn rational(random: &mut Random) -> Vec<Term> {
    let b = positive(random);
    match random.whole(0, 2) {
        0 => vec![term(positive(random), Shape::Saturating(b))],
        1 => vec![stiffness(random), term(positive(random), Shape::Saturating(b))],
        _ => vec![stiffness(random), term(positive(random), Shape::Stiffening(b))],
    }
}

fn with_pole(random: &mut Random) -> Vec<Term> {
    let d = positive(random);
    let pole = random.choose(&[Shape::Gap(d), Shape::Pole(d)]);
    let mut terms = vec![term(positive(random), pole)];
    if random.percent(60.0) {
        terms.push(stiffness(random));
    }
    terms
}

fn barrier(random: &mut Random) -> Vec<Term> {
    let d = positive(random);
    let shape = random.choose(&[Shape::Barrier(d), Shape::Step(d), Shape::Walls(d)]);
    let stiff =
        if random.percent(30.0) { number(random.between(1e2, 1e6)) } else { positive(random) };
    let first = if random.percent(30.0) {
        term(positive(random), Shape::Sine(Number::new(1, 0)))
    } else {
        stiffness(random)
    };
    vec![first, term(stiff, shape)]
}

fn bump(random: &mut Random) -> Vec<Term> {
    let sharp = number(random.between(1.0, 3e4));
    let (place, height) = if random.percent(40.0) {
        (Number::new(0, 0), random.between(0.1, 3.0))
    } else {
        (
            number(random.between(0.5, 2.0) * if random.percent(50.0) { -1.0 } else { 1.0 }),
            random.between(0.01, 2.0),
        )
    };
    // The slope of the bump in its middle is its coefficient.
    let steep = if place.mantissa == 0 { height } else { height * sharp.value().sqrt() };
    vec![stiffness(random), term(number(steep), Shape::Bump(place, sharp))]
}

fn static_load(random: &mut Random) -> Vec<Term> {
    let mut terms = vec![stiffness(random)];
    match random.whole(0, 3) {
        0 => terms.push(term(positive(random), Shape::Power(3))),
        1 => terms.push(term(positive(random), Shape::SignedPower(2, 1))),
        2 => terms.push(term(positive(random), Shape::Sinh(Number::new(1, 0)))),
        _ => {
            terms.push(term(positive(random), Shape::Power(3)));
            terms.push(term(positive(random), Shape::Power(5)));
        }
    }
    let load = number(random.between(0.05, 2.0));
    terms.push(term(Number::new(-load.mantissa, load.exponent), Shape::Constant));
    terms
}

fn cosine_load(random: &mut Random) -> Vec<Term> {
    let load = number(random.between(0.05, 0.9));
    vec![
        stiffness(random),
        term(Number::new(-load.mantissa, load.exponent), Shape::Cosine(Number::new(1, 0))),
    ]
}

fn several_wells(random: &mut Random) -> Vec<Term> {
    let back = positive(random);
    let back = Number::new(-back.mantissa, back.exponent);
    if random.percent(50.0) {
        vec![
            stiffness(random),
            term(back, Shape::Power(3)),
            term(positive(random), Shape::Power(5)),
        ]
    } else {
        vec![
            stiffness(random),
            term(back, Shape::Power(2)),
            term(positive(random), Shape::Power(3)),
        ]
    }
}

fn parameters(random: &mut Random) -> Vec<Term> {
    let name = random.choose(&["eps", "k", "beta"]);
    let shape = random.choose(&[
        Shape::Power(3),
        Shape::Power(5),
        Shape::Power(2),
        Shape::SignedPower(2, 1),
    ]);
    vec![stiffness(random), Term { coefficient: either(random), shape, name: Some(name) }]
}

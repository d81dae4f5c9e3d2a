//! Equation (7) as it is followed: in free flight by time, in contact by a variable of its own.
//!
//! In time the contact force (x - x_r)^(3/2) is not analytic at the touch; with x = x_r + w^2 and
//! dt = w ds it is a polynomial in w, and touch and release are simple zeros of w, however slow the
//! touch. (The change of variable is that of Levi-Civita and Sundman for collisions; the
//! recurrences: A. Jorba and M. Zou, *Experimental Math.* 14 (2005) 99.) A left barrier is a right
//! one seen in a mirror: x, v, beta and the direction of friction change sign.
//!
//! `recurrences` is written from these lines, by [`Equations::to_rust`]; the test below holds the
//! one against the other, and writes the file anew where they differ. A force is one more term
//! here.

use crate::series::written::Equations;

/// What the letters are called in `series::Inputs`.
const PARAMETERS: &[[&str; 2]] = &[
    ["dry", "inputs.dry[lane]"],
    ["arctangent", "inputs.arctangent[lane]"],
    ["viscous", "inputs.viscous[lane]"],
    ["beta", "inputs.beta[lane]"],
    ["eta", "inputs.eta[lane]"],
    ["gamma", "inputs.gamma[lane]"],
    ["mu", "inputs.mu[lane]"],
    ["x_r", "inputs.base[lane]"],
    ["k", "STEEPNESS"],
];

const SWITCHES: &[[&str; 2]] = &[
    ["arctangent", "terms.arctangent"],
    ["beta", "terms.excited"],
    ["mu", "terms.damped_contact"],
];

const STARTS: &[[&str; 2]] = &[
    ["sine", "inputs.sine"],
    ["cosine", "inputs.cosine"],
    ["drive", "inputs.drive[0]"],
    ["counter", "inputs.drive[1]"],
];

pub(super) const FLIGHT: Equations = Equations {
    name: "flight",
    about: "The series of free motion to this order, by time.",
    lines: &[
        "x' = v",
        "drive = sin(eta*t)",
        "counter = cos(eta*t)",
        "sine = sin(x)",
        "cosine = cos(x)",
        "slowing = atan(k*v)",
        "force = -sine - viscous*v - dry - arctangent*slowing + beta*drive*cosine",
        "v' = force",
        "t' = 1",
    ],
    states: &[
        ["x", "place", "inputs.place"],
        ["v", "velocity", "inputs.velocity"],
        ["t", "time", "[0.0; L]"],
    ],
    starts: STARTS,
    parameters: PARAMETERS,
    switches: SWITCHES,
    stretch: "in_flight",
};

pub(super) const CONTACT: Equations = Equations {
    name: "contact",
    about: "The series of motion in contact to this order, by s: x = x_r + w^2, dt = w ds.",
    lines: &[
        "t' = w",
        "w' = v/2",
        "depth = w^2",
        "drive = sin(eta*t)",
        "counter = cos(eta*t)",
        "sine = sin(x_r + depth)",
        "cosine = cos(x_r + depth)",
        "fourth = depth^2",
        "slowing = atan(k*v)",
        "slow = sine + dry + arctangent*slowing - beta*drive*cosine",
        "force = -w*slow - gamma*fourth - mu*v*fourth",
        "(v + viscous*depth)' = force",
    ],
    states: &[
        ["w", "place", "inputs.place"],
        ["v", "velocity", "inputs.velocity"],
        ["t", "time", "[0.0; L]"],
    ],
    starts: STARTS,
    parameters: PARAMETERS,
    switches: SWITCHES,
    stretch: "in_contact",
};

/// Where they are written to.
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/src/impact/taylor/recurrences.rs");

const HEAD: &str = "//! The series of a step of equation (7). Written from the lines in `equations` by its test: a
//! change here is lost.

use super::kernels::{INVERSE, each, product, quotient, sine_and_cosine, square, time, waves_of_time};
use super::series::{Coefficients, HIGHEST_ORDER, Inputs, Terms};
use super::stretch::{in_contact, in_flight, stretched, stretched_next};
use crate::impact::model::STEEPNESS;
";

mod tests {
    use std::collections::BTreeMap;

    use super::super::recurrences::{contact, flight};
    use super::super::series::{Coefficients, Inputs, Series, TIME_TERMS, Terms};
    use super::super::stretch::{in_contact, in_flight};
    use super::*;
    use crate::expr::parse_expression;
    use crate::impact::model::STEEPNESS;
    use crate::series::recurrence::Recurrences;
    use crate::symbol::Symbol;

    /// What is compiled is what the lines above say. Layout aside, which the formatter has its own
    /// mind about.
    #[test]
    fn what_is_compiled_is_written_from_the_equations() {
        let functions =
            [&FLIGHT, &CONTACT].map(|equations| equations.to_rust().expect(equations.name));
        let source = format!("{HEAD}\n{}\n{}", functions[0], functions[1]);
        let plain = |text: &str| {
            let text: String = text.split_whitespace().collect();
            let mut text = text.replace(",)", ")").replace(",]", "]").replace(",}", "}");
            // A closure that takes a line of its own gets braces.
            while let Some(open) = text.find("|lane|{") {
                let open = open + "|lane|".len();
                let close = open + text[open..].find('}').expect("a brace that closes");
                text.remove(close);
                text.remove(open);
            }
            text
        };
        if plain(&std::fs::read_to_string(FILE).unwrap_or_default()) != plain(&source) {
            std::fs::write(FILE, source).expect(FILE);
            panic!(
                "{FILE} was not what follows from the equations; it is written anew: `cargo fmt`, and test again"
            );
        }
    }

    const ORDER: usize = 24;

    /// A start with every force on, which the terms of a test switch off.
    fn inputs(terms: Terms) -> Inputs<1> {
        let on = |on: bool, value: f64| [if on { value } else { 0.0 }];
        let angle = 0.4_f64 + 0.3 * 0.3;
        let (sine, cosine) = (1.3_f64 * 0.7).sin_cos();
        Inputs {
            place: [0.3],
            velocity: [0.02],
            sine: [angle.sin()],
            cosine: [angle.cos()],
            drive: [[sine], [cosine]],
            unit: [0.01],
            hertz: [[0.35], [30.0]],
            dry: [0.05],
            arctangent: on(terms.arctangent, 0.11),
            viscous: [0.2],
            beta: on(terms.excited, 0.6),
            eta: [1.3],
            gamma: [500.0],
            mu: on(terms.damped_contact, 70.0),
            ..Inputs::new()
        }
    }

    /// The series of a system of equations as written, by the recurrences of their expressions:
    /// state by state.
    fn by_expressions(
        states: &[(&str, f64)],
        rates: &[&str],
        (inputs, [[p], [q]]): (&Inputs<1>, [[f64; 1]; 2]),
    ) -> Vec<Vec<f64>> {
        // r is counted in units, as the other series are.
        let unit = inputs.unit[0];
        let number = |name: &str, value: [f64; 1]| (Symbol::from(name), value[0]);
        let numbers = BTreeMap::from([
            number("dry", inputs.dry),
            number("arctangent", inputs.arctangent),
            number("viscous", inputs.viscous),
            number("beta", inputs.beta),
            number("eta", inputs.eta),
            number("gamma", inputs.gamma),
            number("mu", inputs.mu),
            number("x_r", [0.4]),
            number("k", [STEEPNESS]),
            number("p", [p / unit]),
            number("q", [q / (unit * unit)]),
        ]);
        let variables: Vec<(Symbol, Option<usize>)> =
            states.iter().map(|(name, _)| (Symbol::from(*name), None)).collect();
        let mut recurrences = Recurrences::new(&variables, &numbers, ORDER);
        let rates: Vec<usize> = rates
            .iter()
            .map(|text| recurrences.add(&parse_expression(text).expect(text)).expect(text))
            .collect();
        let mut tape = recurrences.into_tape();
        for (place, (_, value)) in states.iter().enumerate() {
            tape.set(place, 0, *value);
        }
        for order in 0..ORDER {
            tape.compute(order);
            for (place, rate) in rates.iter().enumerate() {
                tape.feed(place, *rate, order, inputs.unit[0]);
            }
        }
        (0..states.len()).map(|place| tape.series(place).to_vec()).collect()
    }

    fn assert_same(own: &Series<1>, other: &[f64], what: &str) {
        let size = other.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        for (n, (own, other)) in own.iter().zip(other).enumerate() {
            assert!(
                (own[0] - other).abs() <= 1e-13 * (other.abs() + 1e-3 * size),
                "{what}, order {n}: {} and {other}",
                own[0]
            );
        }
    }

    /// What stands in this file by hand is what follows from the equations of its head as
    /// expressions, coefficient by coefficient.
    #[test]
    fn the_series_are_those_of_the_expressions() {
        for bits in 0..8 {
            let terms = Terms {
                arctangent: bits & 1 != 0,
                excited: bits & 2 != 0,
                damped_contact: bits & 4 != 0,
            };
            let mut now = inputs(terms);
            let mut series = Coefficients::<1>::new();
            contact(&now, ORDER, terms, &mut series);
            let other = by_expressions(
                &[("w", 0.3), ("v", 0.02), ("t", 0.7), ("r", 0.0)],
                &[
                    "(1 + p*r + q*r^2)*v/2",
                    "(1 + p*r + q*r^2)*(-w*(sin(x_r + w^2) + dry + arctangent*atan(k*v) - beta*sin(eta*t)*cos(x_r + w^2)) \
                     - viscous*w*v - (gamma + mu*v)*w^4)",
                    "(1 + p*r + q*r^2)*w",
                    "1",
                ],
                (&now, in_contact(&now)),
            );
            assert_same(&series.place, &other[0], "w");
            assert_same(&series.velocity, &other[1], "v in contact");
            assert_same(&series.time, &[&[0.0], &other[2][1..]].concat(), "t");
            let x = 0.4 + 0.3 * 0.3;
            now.place = [x];
            flight(&now, ORDER, terms, &mut series);
            let other = by_expressions(
                &[("x", x), ("v", 0.02), ("t", 0.7), ("r", 0.0)],
                &[
                    "(1 + p*r + q*r^2)*v",
                    "(1 + p*r + q*r^2)*(-viscous*v - sin(x) - dry - arctangent*atan(k*v) + beta*sin(eta*t)*cos(x))",
                    "1 + p*r + q*r^2",
                    "1",
                ],
                (&now, in_flight(&now)),
            );
            assert_same(&series.time, &[&[0.0], &other[2][1..TIME_TERMS]].concat(), "t in flight");
            assert_same(&series.place, &other[0], "x");
            assert_same(&series.velocity, &other[1], "v in flight");
        }
    }
}

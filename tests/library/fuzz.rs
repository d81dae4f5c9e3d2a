//! Whatever is typed is answered or refused: no panic, from text to printed result.
//!
//! `cargo test` runs a few hundred inputs;
//! `LINDSTEDT_FUZZ_CASES=500000 cargo test --release --test fuzz` runs half a million of either
//! kind.

use lindstedt::Oscillator;
use lindstedt::Values;
use lindstedt::export::{json, latex, text};
use lindstedt::expr::parse_expression;
use lindstedt::method::{Options, solve};
use lindstedt::problem::Problem;
use lindstedt::solution::{AmplitudeConvention, Method};
use lindstedt::verify::comparison::compare;
use proptest::prelude::*;

fn cases() -> u32 {
    std::env::var("LINDSTEDT_FUZZ_CASES").ok().and_then(|number| number.parse().ok()).unwrap_or(100)
}

/// Pieces of equations, right and wrong, in any order.
fn pieces() -> impl Strategy<Value = String> {
    let piece = prop::sample::select(vec![
        "x", "x'", "x''", "t", "eps", "k", "mu", "A", "pi", "y''", "0", "1", "2", "1/3", "0.5",
        "1e3", "1e-300", "9", "+", "-", "*", "/", "^", "**", "(", ")", "(", ")", "sin(", "cos(",
        "exp(", "log(", "sqrt(", "abs(", "sgn(", "H(", "max(", ",", "=", "=0", " ", "^2", "^3",
        "^(1/3)", "''", "²", "\u{0}",
    ]);
    prop::collection::vec(piece, 0..24).prop_map(|pieces| pieces.concat())
}

/// An equation of motion that is spelled correctly, with any force.
fn equations() -> impl Strategy<Value = String> {
    let leaf = prop::sample::select(vec![
        "x", "x", "x", "x'", "eps", "k", "1", "2", "1/2", "3", "0", "pi", "t",
    ])
    .prop_map(str::to_owned);
    let force = leaf.prop_recursive(4, 24, 3, |inner| {
        prop_oneof![
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a} + {b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("{a}*{b}")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a} - {b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a})/({b})")),
            (inner.clone(), 0..5_u32).prop_map(|(a, n)| format!("({a})^{n}")),
            (inner.clone(), prop::sample::select(vec!["1/2", "-1", "3/2", "1/3"]))
                .prop_map(|(a, n)| format!("({a})^({n})")),
            (
                prop::sample::select(vec![
                    "sin", "cos", "tan", "exp", "log", "tanh", "atan", "sqrt", "abs", "sgn", "H"
                ]),
                inner
            )
                .prop_map(|(name, a)| format!("{name}({a})")),
        ]
    });
    (force, prop::bool::ANY).prop_map(|(force, linear)| {
        format!("x'' + {}{force} = 0", if linear { "x + eps*" } else { "" })
    })
}

/// The whole way, from text to every export.
fn answer(equation: &str) {
    let Ok(oscillator) = Oscillator::parse(equation) else {
        return;
    };
    for method in Method::ALL {
        for amplitude in [AmplitudeConvention::Initial, AmplitudeConvention::FirstHarmonic] {
            let options = Options {
                method: Some(method),
                order: Some(2),
                amplitude: Some(amplitude),
                ..Options::default()
            };
            match solve(&oscillator, &options) {
                Err(refusal) => assert!(!refusal.to_string().is_empty()),
                Ok(solution) => {
                    let document = json::solution(&solution, None);
                    let written = serde_json::to_value(&document).expect("JSON");
                    let read = json::read_solution(&written).expect("what is written can be read");
                    assert_eq!(json::solution(&read, None), document);
                    assert!(!text::solution(&solution, None).is_empty());
                    assert!(
                        !text::steps(&solution).is_empty()
                            && !latex::solution(&solution, None).is_empty()
                    );
                }
            }
        }
    }
}

/// Every method judged, with one for each parameter.
fn compared(equation: &str, amplitude: &str) {
    let Ok(oscillator) = Oscillator::parse(equation) else {
        return;
    };
    let mut values = Values::default();
    for name in &oscillator.parameters {
        values.insert(*name, "1".parse().expect("a number")).expect("a value");
    }
    values.insert("A".into(), amplitude.parse().expect("a number")).expect("a value");
    if std::env::var_os("LINDSTEDT_FUZZ_TRACE").is_some() {
        eprintln!("{amplitude} {equation}");
    }
    if let Ok(table) = compare(&oscillator, &values, None, 0.01) {
        assert!(!text::comparison(&table, 80).is_empty() && !latex::comparison(&table).is_empty());
        assert_eq!(json::comparison(&table).equation, table.equation.to_string());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn pieces_of_equations_never_panic(text in pieces()) {
        let _ = parse_expression(&text);
        answer(&text);
    }

    #[test]
    fn equations_with_any_force_never_panic(text in equations()) {
        answer(&text);
    }

    #[test]
    fn comparisons_never_panic(text in equations(), amplitude in prop::sample::select(vec!["1/2", "-2", "1e6", "1e-6"])) {
        compared(&text, amplitude);
    }

    #[test]
    fn any_text_is_parsed_or_refused(text in any::<String>()) {
        let _ = parse_expression(&text);
        let _ = Oscillator::parse(&text);
        let _ = text.parse::<Problem>();
    }
}

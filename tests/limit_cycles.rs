//! Self-excited oscillators: amplitudes, stability and frequencies of limit cycles against an independent truth.

use std::f64::consts::TAU;

use lindstedt::Oscillator;
use lindstedt::expr::parse_expression;
use lindstedt::method::{Options, solve};
use lindstedt::solution::Solution;
use lindstedt::verify::{Values, Verdict, Verification, judge};

fn derive(equation: &str, options: &Options) -> (Oscillator, Solution) {
    let oscillator = Oscillator::parse(equation).expect(equation);
    let solution = solve(&oscillator, options).unwrap_or_else(|refusal| panic!("{equation}: {refusal}"));
    (oscillator, solution)
}

fn judged((oscillator, solution): &(Oscillator, Solution), at: &[(&str, &str)]) -> Verification {
    let mut values = Values::default();
    for (name, value) in at {
        values.insert((*name).into(), parse_expression(value).unwrap()).unwrap();
    }
    judge(oscillator, solution, &values, 0.01).unwrap_or_else(|error| panic!("{}: {error}", solution.equation))
}

/// However strongly the cycle of van der Pol's equation attracts or repels, the judge finds it.
#[test]
fn cycles_are_judged_at_any_strength() {
    let van_der_pol = derive("x'' - mu*(1 - x^2)*x' + x = 0", &Options::default());
    // Periods by Taylor series of order 30: the digits that step tolerances of 1e-12 and 1e-16 have in common.
    for (mu, period) in [
        ("10", 19.078_369_566_94),
        ("20", 34.682_323_311_65),
        ("-20", 34.682_323_311_65),
        ("-3/10", 6.318_443_203_454),
    ] {
        let judged = judged(&van_der_pol, &[("mu", mu)]);
        let found = TAU / judged.true_frequency;
        assert!((found / period - 1.0).abs() < 1e-9, "mu = {mu}: {found}");
        // omega^2 = 1 - mu^2/8 is not positive at 10 and 20, and the verdict says so.
        assert_eq!(judged.verdict == Verdict::Pass, mu == "-3/10");
    }
}

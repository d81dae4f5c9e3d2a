//! Nonlinear normal modes, held to published laws, to the equations themselves, and to motions found
//! by shooting.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use lindstedt::coupled::CoupledEquations;
use lindstedt::exact::rational::to_f64;
use lindstedt::exact::{Polynomial, Rational};
use lindstedt::expr::{CompiledFunction, Expr};
use lindstedt::mechanics::Mechanism;
use lindstedt::modes::{
    FreeSystem, ModeError, ModeOptions, NonlinearMode, NormalModes, OneHarmonicFamily, derive,
    one_harmonic_modes,
};
use lindstedt::numeric::ode::{IntegrationOptions, Point, integrate_first_order};
use lindstedt::solution::{AmplitudeConvention, defined_values};
use lindstedt::verify::{VerificationError, judge_mode, judge_one_harmonic};
use lindstedt::{Interrupt, Symbol, Verdict};
use num_traits::One as _;

const PAIR: &str = "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0";

fn modes_of(equations: &str, options: &ModeOptions) -> NormalModes {
    let system = FreeSystem::parse(equations).expect(equations);
    derive(&system, options).expect(equations)
}

fn to_order(order: u32) -> ModeOptions {
    ModeOptions { order: Some(order), ..ModeOptions::default() }
}

fn formulas(found: &NormalModes) -> Vec<&NonlinearMode> {
    found.modes.iter().map(|mode| mode.as_ref().expect("a formula")).collect()
}

/// The values of the symbols of a mode, definitions among them.
fn values_of(mode: &NonlinearMode, values: &[(&str, f64)]) -> BTreeMap<Symbol, f64> {
    let known: BTreeMap<Symbol, f64> =
        values.iter().map(|(name, value)| (Symbol::new(name), *value)).collect();
    let defined = defined_values(&mode.definitions, &|name| known.get(&name).copied());
    known.clone().into_iter().chain(defined.expect("values")).collect()
}

fn omega_squared(mode: &NonlinearMode, values: &[(&str, f64)]) -> f64 {
    let all = values_of(mode, values);
    mode.frequency_squared.evaluate(|name| all.get(&name).copied()).expect("values")
}

/// The coordinates of a mode by its formula, with their first and second derivatives in theta.
fn motion(mode: &NonlinearMode, values: &[(&str, f64)], theta: f64) -> Vec<[f64; 3]> {
    let all = values_of(mode, values);
    let of = |series: &lindstedt::series::FourierSeries<_>| {
        let mut place = [0.0; 3];
        for (k, cosine, _) in series.harmonics() {
            let size = cosine.evaluate(|name| all.get(&name).copied()).expect("values");
            let k = k as f64;
            let (sine, cosine) = (k * theta).sin_cos();
            place[0] += size * cosine;
            place[1] -= k * size * sine;
            place[2] -= k * k * size * cosine;
        }
        place
    };
    mode.motion.iter().map(of).collect()
}

/// What is left of the equations along a formula, the largest over half a period.
fn residual(equations: &str, mode: &NonlinearMode, values: &[(&str, f64)]) -> f64 {
    let system = CoupledEquations::parse(equations).expect(equations);
    let names: Vec<Symbol> = system
        .coordinates
        .iter()
        .flat_map(|name| [*name, name.derivative(), name.derivative().derivative()])
        .chain(values.iter().map(|(name, _)| Symbol::new(name)))
        .collect();
    let left: Vec<CompiledFunction> = system
        .equations
        .iter()
        .map(|(left, right)| CompiledFunction::new(&(left - right), &names).expect("compiled"))
        .collect();
    let square = omega_squared(mode, values);
    let mut largest = 0.0_f64;
    for step in 0..40 {
        let theta = PI * f64::from(step) / 39.0;
        let states = motion(mode, values, theta);
        let arguments: Vec<f64> = states
            .iter()
            .flat_map(|[q, by_theta, twice]| [*q, square.sqrt() * by_theta, square * twice])
            .chain(values.iter().map(|(_, value)| *value))
            .collect();
        largest = left.iter().map(|left| left.call(&arguments).abs()).fold(largest, f64::max);
    }
    largest
}

/// The exponent with which the residual vanishes with the amplitude.
fn residual_slope(equations: &str, mode: &NonlinearMode, values: &[(&str, f64)], a: f64) -> f64 {
    let at = |amplitude: f64| {
        let own: Vec<(&str, f64)> =
            values.iter().copied().chain([(mode.amplitude.symbol().name(), amplitude)]).collect();
        residual(equations, mode, &own)
    };
    (at(a) / at(0.5 * a)).log2()
}

/// G. Kerschen, M. Peeters, J. C. Golinval and A. F. Vakakis, *Mech. Syst. Signal Process.* 23 (2009)
/// 170: the equations; the series are exact to order 4.
#[test]
fn two_masses_with_a_cubic_spring() {
    let found = modes_of(PAIR, &ModeOptions::default());
    let laws: Vec<String> = formulas(&found).iter().map(|mode| mode.formula()).collect();
    assert_eq!(
        laws,
        ["omega^2 = 1 + 3*a^2/16 - 101*a^4/2048", "omega^2 = 3 + 3*a^2/16 + 1429*a^4/26624"]
    );
    // By one harmonic x(0) = 1.1264 has omega = 1.1; in truth 1.098412688, by a shooting of its own.
    let high =
        modes_of(PAIR, &ModeOptions { amplitude: AmplitudeConvention::Initial, ..to_order(2) });
    let at = "A = sqrt(8*0.21*1.79/(3*0.79))".parse().expect("a value");
    let judged = judge_mode(&high.system, formulas(&high)[0], &at, 0.01, Interrupt::default())
        .expect("a motion");
    assert!((judged.true_frequency - 1.098412688).abs() < 1e-9, "{}", judged.true_frequency);
}

/// What a formula leaves of the equations is of the next order of the amplitude: a check that knows
/// nothing of how it was derived.
#[test]
fn formulas_solve_the_equations_to_their_order() {
    let cart =
        "(1 + m)*x'' + m*cos(y)*y'' - m*sin(y)*y'^2 + k*x = 0; y'' + cos(y)*x'' + sin(y) = 0";
    for (equations, values) in [
        (PAIR, &[][..]),
        ("x'' + 2*x - y + x^2 - x*y/3 = 0; 3*y'' + 4*y - x + y^3/5 = 0", &[]),
        ("x'' + 6*x - 2*y + x*y^2 = 0; 2*y'' + 5*y - 2*x + x^2*y = 0", &[]),
        (cart, &[("m", 0.3), ("k", 2.5)]),
        (
            "m*x'' + (k + c)*x - c*y + g*x^3 = 0; y'' + (1 + c)*y - c*x + y^2/4 = 0",
            &[("m", 1.7), ("k", 2.0), ("c", 0.6), ("g", 0.8)],
        ),
        ("(1 + x^2)*x'' + x*x'^2 + 5*x - y = 0; y'' + 2*y - x + y*y'^2/3 = 0", &[]),
        ("x'' + sin(x) + k*(x - y) = 0; 2*y'' + sin(y) + k*(y - x) = 0", &[("k", 0.4)]),
        ("x'' + 2*x - y = 0; y'' + 2*y - x - z = 0; z'' + 2*z - y + z^3 = 0", &[]),
    ] {
        for order in [1, 2, 3, 4] {
            let found = modes_of(equations, &to_order(order));
            for mode in formulas(&found) {
                let slope = residual_slope(equations, mode, values, 0.05);
                // The motion has one power more than the square of the frequency, and the residual
                // begins one above.
                let least = f64::from(order) + 2.0;
                assert!(slope > least - 0.15, "{equations} order {order}: {slope}");
            }
        }
    }
}

/// A motion begun as a formula of high order says comes back after its period, by Runge-Kutta here.
#[test]
fn a_formula_of_high_order_closes() {
    let found = modes_of(PAIR, &to_order(16));
    for mode in formulas(&found) {
        let values = [("a", 0.5)];
        let start = motion(mode, &values, 0.0);
        let period = 2.0 * PI / omega_squared(mode, &values).sqrt();
        let rates = |_: f64, state: &[f64; 4], out: &mut [f64; 4]| {
            let [x, y, by_x, by_y] = *state;
            *out = [by_x, by_y, -2.0 * x + y - x.powi(3) / 2.0, -2.0 * y + x];
        };
        let begin = [start[0][0], start[1][0], 0.0, 0.0];
        let options = IntegrationOptions::with_tolerance(1e-13);
        let path = integrate_first_order(rates, Point { t: 0.0, y: begin }, period, &[], &options);
        let end = path.expect("a path").end().y;
        for (one, other) in end.iter().zip(&begin) {
            assert!((one - other).abs() < 1e-9, "mode {}: {end:?} {begin:?}", mode.number);
        }
    }
}

/// Random systems of two and three coordinates: the error of the frequency vanishes as the order
/// promises, by shooting. `LINDSTEDT_MODE_CASES` sets their number.
#[test]
fn random_systems_err_as_their_order_promises() {
    let cases = std::env::var("LINDSTEDT_MODE_CASES").ok().and_then(|count| count.parse().ok());
    let mut state = 88_172_645_463_325_252_u64;
    let mut below = |bound: u64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 20) % bound
    };
    let mut judged_modes = 0;
    for _ in 0..cases.unwrap_or(40) {
        let count = 2 + below(2) as usize;
        let names = &["x", "y", "z"][..count];
        let lower: Vec<Vec<u64>> = (0..count).map(|i| (0..i).map(|_| below(3)).collect()).collect();
        let coupling = |i: usize, j: usize| match i == j {
            true => 0,
            false => lower[i.max(j)][i.min(j)],
        };
        let mut equations = Vec::new();
        for (i, name) in names.iter().enumerate() {
            let own = 2 + below(6) + (0..count).map(|j| coupling(i, j)).sum::<u64>();
            let mut text = format!("{}*{name}'' + {own}*{name}", 1 + below(3));
            for (j, other) in names.iter().enumerate().filter(|(j, _)| coupling(i, *j) > 0) {
                text.push_str(&format!(" - {}*{other}", coupling(i, j)));
            }
            for _ in 0..2 {
                let [one, two, three] = [(); 3].map(|()| names[below(count as u64) as usize]);
                let (above, under) = (1 + below(5), 2 + below(4));
                let sign = if below(2) == 0 { "+" } else { "-" };
                text.push_str(&match below(3) {
                    0 => format!(" {sign} {above}*{one}*{two}/{under}"),
                    1 => format!(" {sign} {above}*{one}*{two}*{three}/{under}"),
                    _ => format!(" {sign} {above}*{one}*{two}'*{three}'/{under}"),
                });
            }
            equations.push(text + " = 0");
        }
        let equations = equations.join("; ");
        let found = modes_of(&equations, &to_order(2));
        for mode in found.modes.iter().flatten() {
            // The amplitude is that of the first coordinate, which may be the one that moves least.
            let largest = mode.linear.shape.iter().filter_map(|entry| entry.as_number());
            let largest = largest.map(|entry| to_f64(&entry).abs()).fold(1.0, f64::max);
            let values = format!("a = 1/{}", (10.0 * largest).ceil()).parse().expect("a value");
            let judged = judge_mode(&found.system, mode, &values, 0.01, Interrupt::default());
            let judged = match judged {
                Ok(judged) => judged,
                // Beside an internal resonance, which is said, the motion may turn back at a smaller
                // amplitude.
                Err(VerificationError::NoMode { .. }) if !mode.near.is_empty() => continue,
                Err(error) => panic!("{equations}: {error}"),
            };
            // omega^2 is even in the amplitude of the first harmonic; near a resonance the next terms
            // are large, and the exponent is seen at smaller amplitudes only.
            if let Some(slope) = judged.slope {
                assert!(slope > 3.0, "{equations} mode {}: {slope} {judged:?}", mode.number);
                judged_modes += 1;
            }
        }
    }
    assert!(judged_modes > 10, "{judged_modes}");
}

/// The energy along the formula of a mode changes as little as the order promises: by the power
/// N + 2 of the amplitude or less, where the motion is known to order N and the energy begins with the
/// square.
#[test]
fn the_printed_motion_keeps_its_energy() {
    // x'^2/2 + y'^2/2 + x^2 + y^2 - x y + x^4/8 + x^2 y/5 + y^3/15
    let equations = "x'' + 2*x - y + x^3/2 + 2*x*y/5 = 0; y'' + 2*y - x + x^2/5 + y^2/5 = 0";
    for order in [2, 4, 6] {
        for mode in formulas(&modes_of(equations, &to_order(order))) {
            let range = |amplitude: f64| {
                let values = [("a", amplitude)];
                let square = omega_squared(mode, &values);
                let energies = (0..40).map(|step| {
                    let states = motion(mode, &values, PI * f64::from(step) / 39.0);
                    let [[x, by_x, _], [y, by_y, _]] = states[..] else {
                        panic!("two coordinates")
                    };
                    0.5 * square * (by_x * by_x + by_y * by_y) + x * x + y * y - x * y
                        + x.powi(4) / 8.0
                        + x * x * y / 5.0
                        + y.powi(3) / 15.0
                });
                let (least, most) = energies
                    .fold((f64::INFINITY, 0.0_f64), |(least, most), own| {
                        (least.min(own), most.max(own))
                    });
                most - least
            };
            let exponent = (range(0.1) / range(0.05)).log2();
            let promised = f64::from(order) + 2.0;
            assert!(exponent > promised - 0.2, "order {order}, mode {}: {exponent}", mode.number);
        }
    }
}

/// The order in which coordinates are written does not matter if the inertia couples them: an element of
/// the mass matrix that vanishes at rest is no pivot.
#[test]
fn coupled_inertia_may_vanish_at_rest() {
    // A pendulum on a vertical spring, beside an internal resonance 1:2.
    let frequency = |equations: &str, at: &str| {
        let found = modes_of(equations, &to_order(2));
        let mode = formulas(&found)[0];
        let at = at.parse().expect("a value");
        judge_mode(&found.system, mode, &at, 0.01, Interrupt::default())
            .expect(equations)
            .true_frequency
    };
    let [one, other] = [("y", "b"), ("b", "y")].map(|(spring, angle)| {
        frequency(
            &format!(
                "3*{spring}'' + {angle}''*sin({angle}) + {angle}'^2*cos({angle}) + 124*{spring} = 0; \
                 {angle}'' + {spring}''*sin({angle}) + 9.81*sin({angle}) = 0"
            ),
            "a = 1/20",
        )
    });
    assert!((one / other - 1.0).abs() < 1e-11, "{one} {other}");
    // The straight mode is exact.
    let straight = "y'' + 20*y + b''*b = 0; b'' + y''*b + 9*b = 0";
    let found = modes_of(straight, &to_order(2));
    let at = "a = 1/5".parse().expect("a value");
    let judged = judge_mode(&found.system, formulas(&found)[1], &at, 0.01, Interrupt::default());
    let judged = judged.expect("a motion");
    assert!((judged.true_frequency - 20.0_f64.sqrt()).abs() < 1e-11, "{judged:?}");
}

#[test]
fn letters_give_what_their_numbers_give() {
    let letters = "m*x'' + (k + c)*x - c*y + g*x^3 = 0; y'' + (1 + c)*y - c*x = 0";
    let numbers = "2*x'' + (3 + 1/2)*x - y/2 + 4*x^3/5 = 0; y'' + (1 + 1/2)*y - x/2 = 0";
    let [symbolic, numeric] = [letters, numbers].map(|text| modes_of(text, &to_order(4)));
    let values = [("m", 2.0), ("k", 3.0), ("c", 0.5), ("g", 0.8), ("a", 0.3)];
    for (one, other) in formulas(&symbolic).iter().zip(formulas(&numeric)) {
        let [by_letters, by_numbers] =
            [omega_squared(one, &values), omega_squared(other, &[("a", 0.3)])];
        assert!((by_letters - by_numbers).abs() < 1e-12, "{by_letters} {by_numbers}");
        let [left, right] = [motion(one, &values, 0.7), motion(other, &[("a", 0.3)], 0.7)];
        for ([one, ..], [other, ..]) in left.iter().zip(&right) {
            assert!((one - other).abs() < 1e-12, "{one} {other}");
        }
    }
}

/// The sum of coordinates of which the amplitude is that of the first harmonic is 1 for the shape of
/// its own mode and 0 for that of the other, with letters in masses and springs.
#[test]
fn a_modal_coordinate_is_that_of_its_own_mode() {
    let values = [("m", 2.0), ("k", 3.0), ("c", 0.5), ("d", 0.4)];
    for equations in [
        "m*x'' + (k + c)*x - c*y + x^3 = 0; y'' + (1 + c)*y - c*x = 0",
        "(m + d)*x'' + d*y'' + k*x + x^3 = 0; d*x'' + y'' + 7*y = 0",
        "(m + d)*x'' + k*x + x^3 = 0; y'' + 7*y + c*x*y = 0",
        "(m + d)*x'' + k*x + x^3 = 0; c*x'' + (1 + d)*y'' + 7*y = 0",
    ] {
        let found = modes_of(equations, &to_order(2));
        let modes = formulas(&found);
        for (own, mode) in modes.iter().enumerate() {
            let at = |polynomial: &Polynomial, mode: &NonlinearMode| {
                // Definitions of either mode; the amplitude does not occur.
                let all = values_of(mode, &values);
                polynomial.evaluate(|name| all.get(&name).copied()).expect("values")
            };
            for (number, other) in modes.iter().enumerate() {
                let products = mode.linear.modal.iter().zip(&other.linear.shape);
                let sum: f64 =
                    products.map(|(factor, entry)| at(factor, mode) * at(entry, other)).sum();
                let wanted = f64::from(u8::from(own == number));
                assert!((sum - wanted).abs() < 1e-12, "{equations}: {own} {number} {sum}");
            }
        }
    }
}

#[test]
fn both_definitions_of_the_amplitude_are_of_one_motion() {
    for equations in [PAIR, "x'' + 2*x - y + x^2/3 = 0; y'' + 3*y - x = 0"] {
        for amplitude in [AmplitudeConvention::Initial, AmplitudeConvention::FirstHarmonic] {
            let found = modes_of(equations, &ModeOptions { amplitude, ..to_order(3) });
            for mode in formulas(&found) {
                let at = format!("{} = 1/5", mode.amplitude.symbol());
                let judged = judge_mode(
                    &found.system,
                    mode,
                    &at.parse().expect("a value"),
                    0.01,
                    Interrupt::default(),
                )
                .unwrap();
                assert_eq!(judged.verdict, Verdict::Pass);
                assert!(judged.slope.is_some_and(|slope| slope > 3.8), "{equations}: {judged:?}");
                assert!(judged.max_deviation < 2e-3, "{equations}: {judged:?}");
            }
        }
    }
}

#[test]
fn modal_lines_follow_the_motion() {
    let found = modes_of("x'' + 2*x - y + x^2 + x^3/2 = 0; y'' + 3*y - x = 0", &to_order(4));
    for mode in formulas(&found) {
        let apart = |a: f64| {
            let values = [("a", a)];
            let all = values_of(mode, &values);
            let at = |theta: f64| {
                let places = motion(mode, &values, theta);
                let mut all = all.clone();
                all.insert("x".into(), places[0][0]);
                let line = mode.lines[1].evaluate(|name| all.get(&name).copied());
                (line.expect("values") - places[1][0]).abs()
            };
            (0..20).map(|step| at(PI * f64::from(step) / 19.0)).fold(0.0, f64::max)
        };
        let slope = (apart(0.02) / apart(0.01)).log2();
        assert!((slope - 4.0).abs() < 0.2, "{slope}");
    }
}

/// Ten masses in a row: the linear frequencies are no fractions.
#[test]
fn ten_masses_are_followed_in_rounded_numbers() {
    let row = |i: usize| {
        let at = |i: usize| format!("q{i}");
        let mut text = format!("q{i}'' + 2*{} + q{i}^3", at(i));
        if i > 1 {
            text.push_str(&format!(" - {}", at(i - 1)));
        }
        if i < 10 {
            text.push_str(&format!(" - {}", at(i + 1)));
        }
        text + " = 0"
    };
    let equations: Vec<String> = (1..=10).map(row).collect();
    let found = modes_of(&equations.join("; "), &ModeOptions { mode: Some(4), ..to_order(2) });
    let [mode] = formulas(&found)[..] else { panic!("one mode") };
    assert!(mode.rounded);
    // What cancels leaves nothing behind.
    for series in &mode.motion {
        for (_, cosine, _) in series.harmonics() {
            assert!(cosine.terms().all(|(_, number)| to_f64(number).abs() > 1e-12), "{cosine}");
        }
    }
    let linear = 2.0 - 2.0 * (4.0 * PI / 11.0).cos();
    assert!((omega_squared(mode, &[("a", 0.0)]) - linear).abs() < 1e-14);
    let judged = judge_mode(
        &found.system,
        mode,
        &"a = 1/4".parse().expect("a value"),
        0.01,
        Interrupt::default(),
    );
    let judged = judged.expect("a motion");
    assert!(judged.slope.is_some_and(|slope| (slope - 4.0).abs() < 0.3), "{:?}", judged.slope);
}

/// A spring that swings, counted from where its mass hangs: the swing drives the spring at twice its
/// frequency.
#[test]
fn an_elastic_pendulum_has_a_divisor_of_two_to_one() {
    let kinetic = "m*(r'^2 + r^2*b'^2)/2";
    let spring = Mechanism::parse(&["r", "b"], kinetic, "k*(r - L)^2/2 - m*g*r*cos(b)");
    let equations = spring.and_then(|spring| spring.equations()).expect("a mechanism");
    let system = FreeSystem::of_mechanism(&equations).expect("a place of rest");
    let found = derive(&system, &to_order(2)).expect("modes");
    let swing = formulas(&found)[0];
    let values = [("m", 1.0), ("k", 30.0), ("L", 1.0), ("g", 10.0)];
    let all = values_of(swing, &values);
    // g over the length of the spring that hangs
    assert!((all[&"omega1".into()].powi(2) - 10.0 / (1.0 + 10.0 / 30.0)).abs() < 1e-12);
    assert!((all[&"d2".into()] - (30.0 - 4.0 * 7.5)).abs() < 1e-12);
    // Only b swings, and its amplitude is that of b itself, whatever mu1 is.
    let factors: Vec<String> =
        swing.linear.modal.iter().map(|factor| Expr::from(factor).to_string()).collect();
    assert_eq!(
        (&swing.linear.shape[0].as_number(), &factors[0][..], &factors[1][..]),
        (&Some(Rational::one()), "1", "0")
    );
    let judged = judge_mode(
        &found.system,
        swing,
        &"m = 1, k = 50, L = 1, g = 10, a = 1/20".parse().expect("values"),
        0.01,
        Interrupt::default(),
    );
    let judged = judged.expect("a motion");
    assert!(judged.slope.is_some_and(|slope| (slope - 4.0).abs() < 0.1), "{judged:?}");
}

/// The slower mode is the first, in whichever order equations and coordinates come.
#[test]
fn the_order_of_equations_does_not_matter() {
    let cart = "(1 + m)*x'' + m*cos(y)*y'' - m*sin(y)*y'^2 + k*x = 0";
    let swing = "y'' + cos(y)*x'' + sin(y) = 0";
    let values = [("m", 0.3), ("k", 2.5), ("a", 0.1)];
    for equations in [format!("{cart}; {swing}"), format!("{swing}; {cart}")] {
        let found = modes_of(&equations, &to_order(2));
        let squares: Vec<f64> =
            formulas(&found).iter().map(|mode| omega_squared(mode, &values)).collect();
        assert!(squares[0] < squares[1], "{equations}: {squares:?}");
    }
}

#[test]
fn resonance_is_refused_where_it_is_one() {
    // omega_2 = 3 omega_1: one cubic spring drives the other mode, two equal ones do not.
    let one = modes_of("x'' + 5*x - 4*y + x^3 = 0; y'' + 5*y - 4*x = 0", &to_order(4));
    assert_eq!(
        one.modes[0].as_ref().err(),
        Some(&ModeError::InternalResonance { number: 1, other: 2, ratio: 3, order: 3 })
    );
    assert!(one.modes[1].is_ok());
    // Two modes of one frequency that the first one drives at twice its own.
    let several = "x'' + x = x*y; y'' + 4*y + y*z = 0; z'' + 4*z = x^2";
    assert_eq!(
        modes_of(several, &to_order(4)).modes[0].as_ref().err(),
        Some(&ModeError::InternalResonance { number: 1, other: 2, ratio: 2, order: 2 })
    );
    let two = modes_of("x'' + 5*x - 4*y + x^3 = 0; y'' + 5*y - 4*x + y^3 = 0", &to_order(4));
    let laws: Vec<String> = formulas(&two).iter().map(|mode| mode.formula()).collect();
    // In phase both are Duffing's oscillator x'' + x + x^3.
    assert_eq!(laws[0], "omega^2 = 1 + 3*a^2/4 + 3*a^4/128");
    let letters =
        modes_of("x'' + (1 + k)*x - k*y + x^3 = 0; y'' + (1 + k)*y - k*x = 0", &to_order(4));
    // The divisor 2*k - 8 vanishes where omega_2 = 3 omega_1.
    let divisor = formulas(&letters)[0].definitions.iter().find(|own| own.symbol.name() == "d3");
    assert_eq!(divisor.map(|own| own.meaning.to_string()), Some("-8 + 2*k".to_owned()));
}

/// `omega_2 = 3.1 omega_1`: the third harmonic has a small divisor, and it is said.
#[test]
fn near_resonance_is_said() {
    let found = modes_of("x'' + x + x^3 + x*y/9 = 0; y'' + 961*y/100 + x^3 = 0", &to_order(4));
    let near = &formulas(&found)[0].near;
    assert_eq!(near.iter().map(|near| (near.other, near.ratio)).collect::<Vec<_>>(), [(2, 3)]);
    assert!((near[0].distance - (9.61 / 9.0 - 1.0)).abs() < 1e-12, "{near:?}");
    let far = modes_of(PAIR, &to_order(4));
    assert!(formulas(&far).iter().all(|mode| mode.near.is_empty()));
}

#[test]
fn what_has_no_modes_says_why() {
    for (equations, words) in [
        ("x'' + x - y = 0; y'' + y'/10 + y - x = 0", "`y'/10` is odd in the velocities"),
        ("x'' + y' + x = 0; y'' - x' + 2*y = 0", "`y'` is a gyroscopic force"),
        ("x'' + x - y + x^2*x' = 0; y'' + 2*y - x = 0", "is odd in the velocities"),
        ("x'' + x - y = cos(t); y'' + 2*y - x = 0", "depends on time"),
        ("x'' + x - y = 1; y'' + 2*y - x = 0", "leaves the force -1"),
        ("x'' + x - y = 0; y' + 2*y - x = 0", "y moves by an equation of first order"),
        ("x'' + 2*x - y + abs(x)*x = 0; y'' + 2*y - x = 0", "`abs(x)` has no Taylor series"),
        ("x'' + a*x - y = 0; y'' + 2*y - x - z = 0; z'' + 2*z - y = 0", "no closed form in a"),
        ("x'' + x - 2*y = 0; y'' + y + 2*x = 0", "not real"),
        ("x*x'' + x - y = 0; y'' + 2*y - x = 0", "mass matrix is singular"),
    ] {
        let found = FreeSystem::parse(equations)
            .and_then(|system| derive(&system, &ModeOptions::default()));
        let error = found.map(|_| ()).expect_err(equations).to_string();
        assert!(error.contains(words), "{equations}: {error}");
    }
    for (equations, words) in [
        ("x'' - x + y = 0; y'' + 3*y + x = 0", "mode 1 has omega^2 = -1.23607 at rest"),
        ("x'' + x - y = 0; y'' + y - x = 0", "mode 1 has omega = 0 at rest"),
        ("x'' + x + (x - y)^3 = 0; y'' + y + (y - x)^3 = 0", "modes 1 and 2 have one linear"),
        ("x'' + k*x + (x - y)^3 = 0; y'' + k*y = 0", "modes 1 and 2 have one linear"),
    ] {
        let found = modes_of(equations, &ModeOptions::default());
        let error = found.modes[0].as_ref().err().map(ToString::to_string).unwrap_or_default();
        assert!(error.contains(words), "{equations}: {error}");
    }
}

/// The first harmonic of the equations along `x = A cos theta`, `y = r x`, by sums over a turn.
fn unbalanced(system: &FreeSystem, values: &BTreeMap<Symbol, f64>, state: [f64; 3]) -> f64 {
    const POINTS: usize = 64;
    let [amplitude, ratio, frequency] = state;
    let names = &system.equations.coordinates;
    let mut largest = 0.0_f64;
    for (left, right) in &system.equations.equations {
        let mut sum = 0.0;
        for point in 0..POINTS {
            let theta = 2.0 * PI * point as f64 / POINTS as f64;
            let mut at = values.clone();
            for (name, size) in names.iter().zip([amplitude, ratio * amplitude]) {
                let velocity = name.derivative();
                at.insert(*name, size * theta.cos());
                at.insert(velocity, -size * frequency * theta.sin());
                at.insert(velocity.derivative(), -size * frequency * frequency * theta.cos());
            }
            sum += (left - right).evaluate(&at).expect("a force") * theta.cos();
        }
        largest = largest.max((2.0 * sum / POINTS as f64).abs());
    }
    largest / amplitude
}

#[test]
fn one_harmonic_balances_at_every_member_of_a_family() {
    for (equations, values) in [
        (PAIR, vec![("A", 1.1264)]),
        (
            "x'' + x + x^3 + K*(x - y)^3 = 0; y'' + y + y^3 + K*(y - x)^3 = 0",
            vec![("A", 0.7), ("K", 0.2)],
        ),
        (
            "x'' + x + x^3 + k*(x - y) = 0; y'' + y + y^3 + k*(y - x) = 0",
            vec![("A", 1.0), ("k", 0.125)],
        ),
        (
            "x'' + x + x^3 + k*(x - y) = 0; y'' + 2*y + x^2*y + k*(y - x) = 0",
            vec![("A", 0.5), ("k", 0.3)],
        ),
        ("2*x'' + x'' * x^2 + x*x'^2 + 3*x - y = 0; y'' + 2*y - x = 0", vec![("A", 0.4)]),
    ] {
        let system = FreeSystem::parse(equations).expect(equations);
        let modes = match one_harmonic_modes(&system) {
            Ok(modes) => modes,
            Err(error) => panic!("{equations}: {error}"),
        };
        let text: Vec<String> =
            values.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        let judged = judge_one_harmonic(&modes, &text.join(", ").parse().expect("values"), 0.1);
        let judged = judged.expect("judged");
        assert!(judged.motions.len() >= 2, "{equations}: {judged:?}");
        let known = values.iter().map(|(name, value)| (Symbol::new(name), *value)).collect();
        for motion in &judged.motions {
            let left = unbalanced(&system, &known, [values[0].1, motion.ratio, motion.frequency]);
            assert!(left < 1e-10, "{equations}: {motion:?} leaves {left}");
        }
    }
}

/// The backbone goes from the linear mode to the amplitude, and its energy is that of the potential where
/// the motion turns, of typed equations and of a mechanism.
#[test]
fn a_backbone_has_the_energy_of_its_turns() {
    let pair = FreeSystem::parse(PAIR).expect("equations");
    let pendulum = Mechanism::parse(&["r", "x"], "(r'^2 + r^2*x'^2)/2", "7*(r - 1)^2/2 - r*cos(x)");
    let pendulum = pendulum.and_then(|mechanism| mechanism.equations()).expect("equations");
    let pendulum = FreeSystem::of_mechanism(&pendulum).expect("a system");
    let of_pair = |q: &[f64]| q[0] * q[0] + q[1] * q[1] - q[0] * q[1] + q[0].powi(4) / 8.0;
    let of_pendulum = |q: &[f64]| {
        let potential = |r: f64, x: f64| 3.5 * (r - 1.0) * (r - 1.0) - r * x.cos();
        let rest = 1.0 + 1.0 / 7.0;
        potential(rest + q[0], q[1]) - potential(rest, 0.0)
    };
    type Potential<'a> = &'a dyn Fn(&[f64]) -> f64;
    let potentials: [Potential; 2] = [&of_pair, &of_pendulum];
    for (system, potential) in [&pair, &pendulum].into_iter().zip(potentials) {
        let found = derive(system, &to_order(4)).expect("modes");
        for mode in formulas(&found) {
            let at = "a = 2/5".parse().expect("values");
            let judged =
                judge_mode(&found.system, mode, &at, 0.01, Interrupt::default()).expect("judged");
            let [first, .., last] = judged.backbone.as_slice() else { panic!("a backbone") };
            assert_eq!((first.amplitude, first.energy), (0.0, Some(0.0)));
            assert_eq!(last.true_frequency, judged.true_frequency);
            let energy = potential(&judged.paths[1][0]);
            assert!((last.energy.expect("an energy") - energy).abs() < 1e-12 * (1.0 + energy));
        }
    }
}

/// A balance is held to the equations that are printed, and to true motions that it approaches with
/// the number of harmonics: forces of even and odd degree, of accelerations, of a sine, three
/// coordinates, and a coordinate that rests in a mode.
#[test]
fn a_balance_of_harmonics_approaches_the_true_motion() {
    let balanced = |equations: &str, harmonics: u32| {
        modes_of(equations, &ModeOptions { harmonics: Some(harmonics), ..ModeOptions::default() })
    };
    for (equations, amplitude) in [
        (PAIR, 1.5),
        ("x'' + 2*x - y + x^2/3 + x^3/2 = 0; y'' + 2*y - x - x*y/5 = 0", 0.6),
        ("2*x'' + x''*x^2 + x*x'^2 + 3*x - y = 0; y'' + 2*y - x = 0", 0.8),
        ("x'' + sin(x) + (x - y)/3 = 0; y'' + sin(y) + (y - x)/3 = 0", 1.2),
        ("x'' + 2*x - y + x^3 = 0; y'' + 2*y - x - z = 0; z'' + 3*z - y + z^3/2 = 0", 0.3),
        ("x'' + x + x^3 = 0; y'' + 5*y + y^3 = 0", 1.0),
    ] {
        let mut before: Option<Vec<f64>> = None;
        for harmonics in [2, 4, 8] {
            let found = balanced(equations, harmonics);
            let at = format!("A = {amplitude}").parse().expect("values");
            let errors: Vec<f64> = formulas(&found)
                .into_iter()
                .map(|mode| {
                    let judged = judge_mode(&found.system, mode, &at, 0.01, Interrupt::default())
                        .expect(equations);
                    let balance = mode.balance.as_ref().expect("a balance");
                    let known = judged.coefficients.iter().copied();
                    let known = known.chain([
                        (Symbol::new("A"), amplitude),
                        (Symbol::new("omega"), judged.frequency.expect("a frequency")),
                    ]);
                    let known = known.collect();
                    for equation in &balance.equations {
                        let left = equation.evaluate(&known).expect("a value");
                        assert!(left.abs() < 1e-10, "{equations}: {equation} is {left}");
                    }
                    judged.max_deviation
                })
                .collect();
            let limit =
                [0.05, 5e-3, 2e-4][[2, 4, 8].iter().position(|n| *n == harmonics).expect("one")];
            for (index, error) in errors.iter().enumerate() {
                assert!(*error < limit, "{equations}, {harmonics} harmonics: {errors:?}");
                let last = before.as_ref().map_or(1.0, |before| before[index]);
                assert!(*error < 0.3 * last || *error < 1e-9, "{equations}: {errors:?} {before:?}");
            }
            before = Some(errors);
        }
    }
    // Far from rest, and beside a branch that a longer step would come to: softening near a loss of
    // symmetry, hardening a thousand times the linear stiffness, a swing over the horizontal.
    for (equations, number, amplitude, harmonics) in [
        ("x'' + 2*x - y - x^3/2 = 0; y'' + 2*y - x = 0", 2, 2.0, 5),
        (PAIR, 2, 100.0, 6),
        ("x'' + sin(x) + (x - y)/3 = 0; y'' + 2*sin(y) + (y - x)/3 = 0", 2, 4.0, 8),
        ("x'' + x/sqrt(1 + x^2) + x - y = 0; y'' + y - x + y^3 = 0", 1, 2.0, 6),
    ] {
        let found = balanced(equations, harmonics);
        let mode = found.modes[number - 1].as_ref().expect("a mode");
        let at = format!("A = {amplitude}").parse().expect("values");
        let judged =
            judge_mode(&found.system, mode, &at, 0.01, Interrupt::default()).expect(equations);
        let error = judged.relative_error.expect("a frequency").abs();
        assert!(error < 1e-4 && judged.max_deviation < 2e-3, "{equations}: {judged:?}");
    }
    // A force that is no polynomial has no equations that are written out.
    let sine = balanced("x'' + sin(x) = 0; y'' + 2*y = 0", 3);
    assert!(formulas(&sine)[0].balance.as_ref().is_some_and(|own| own.equations.is_empty()));
    let none = FreeSystem::parse(PAIR).expect("equations");
    let too_many = ModeOptions { harmonics: Some(1000), ..ModeOptions::default() };
    assert!(matches!(derive(&none, &too_many), Err(ModeError::Harmonics(1000, _))));
}

#[test]
fn localised_modes_branch_off_where_it_was_published() {
    // Vakakis and Rand 1992: at K = 1/4, at any amplitude.
    let cubic =
        FreeSystem::parse("x'' + x + x^3 + K*(x - y)^3 = 0; y'' + y + y^3 + K*(y - x)^3 = 0")
            .expect("equations");
    let modes = one_harmonic_modes(&cubic).expect("modes");
    let similar =
        modes.families.iter().filter(|family| matches!(family, OneHarmonicFamily::Similar { .. }));
    assert_eq!(similar.count(), 4);
    let [branch] = modes.branch_points.as_slice() else { panic!("{:?}", modes.branch_points) };
    let (left, right) = &branch.at;
    assert_eq!(
        (branch.ratio.to_string(), left.to_string(), right.to_string()),
        ("-1".into(), "K".into(), "1/4".into())
    );
    // Of numbers on both sides of it the two others are there, or not.
    for (coupling, count) in [("K = 0.24, A = 1/2", 4), ("K = 0.26, A = 1/2", 2)] {
        let judged =
            judge_one_harmonic(&modes, &coupling.parse().expect("values"), 0.05).expect("judged");
        assert_eq!(judged.motions.len(), count, "{coupling}: {judged:?}");
    }
    let refused = |equations: &str| {
        one_harmonic_modes(&FreeSystem::parse(equations).expect(equations)).expect_err(equations)
    };
    assert!(matches!(refused("x'' + x + x^2 = 0; y'' + 2*y = 0"), ModeError::EvenDegree(_)));
    assert!(matches!(refused("x'' + sin(x) = 0; y'' + 2*y = 0"), ModeError::NotPolynomial(_)));
    assert!(matches!(
        refused("x'' + x = 0; y'' + 2*y = 0; z'' + 3*z + z^3 = 0"),
        ModeError::NotTwo(3)
    ));
}

/// An approximant agrees with the series of its order, and at an amplitude where the terms of the series
/// no longer fall it is nearer to the true frequency.
#[test]
fn an_approximant_agrees_with_its_series_and_reaches_further() {
    let system = FreeSystem::parse(PAIR).expect("equations");
    let mode = |options: &ModeOptions| {
        let mut found = derive(&system, options).expect("modes").modes;
        found.swap_remove(0).expect("a formula")
    };
    let [series, quotient] =
        [mode(&to_order(6)), mode(&ModeOptions { pade: Some((2, 1)), ..ModeOptions::default() })];
    let own = quotient.approximant.clone().expect("an approximant");
    // numerator = denominator * series + O(a^8), exactly.
    let rest = own.below.product(&series.frequency_squared) + own.above.map(|number| -number);
    let amplitude = quotient.amplitude.symbol();
    assert!(rest.terms().next().is_some());
    assert!(rest.terms().all(|(term, _)| term.exponent(amplitude) >= 8));
    let error = |mode: &NonlinearMode| {
        let judged = judge_mode(
            &system,
            mode,
            &"a = 6/5".parse().expect("a value"),
            0.01,
            Interrupt::default(),
        );
        judged.expect("a motion").relative_error.expect("a frequency").abs()
    };
    assert!(5.0 * error(&quotient) < error(&series));
    let refused = derive(
        &FreeSystem::parse("x'' + 2*x - y = 0; y'' + 2*y - x = 0").expect("equations"),
        &ModeOptions { pade: Some((1, 1)), ..ModeOptions::default() },
    );
    let reason = refused.expect("modes").modes[0].clone().expect_err("a linear law is no quotient");
    assert!(reason.to_string().contains("approximant [1/1]"), "{reason}");
}

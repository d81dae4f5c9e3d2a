//! Several drives, a base that moves, and forces whose first power is high: steady motions against
//! the true ones, found by shooting.

use lindstedt::expr::Expr;
use lindstedt::method::{Options, solve};
use lindstedt::solution::{Method, Note, Solution};
use lindstedt::verify::Verification;
use lindstedt::verify::VerificationError;
use lindstedt::{Oscillator, Symbol, Values, Verdict, judge};

fn derived(
    equation: &str,
    resonance: Option<(u32, u32)>,
    order: Option<u32>,
) -> (Oscillator, Solution) {
    let oscillator = Oscillator::parse(equation).expect(equation);
    let options =
        Options { method: Some(Method::MultipleScales), order, resonance, ..Options::default() };
    let solution =
        solve(&oscillator, &options).unwrap_or_else(|refusal| panic!("{equation}: {refusal}"));
    (oscillator, solution)
}

fn judged(equation: &str, resonance: (u32, u32), order: u32, at: &str) -> Verification {
    let (oscillator, solution) = derived(equation, Some(resonance), Some(order));
    let at: Values = at.parse().expect(at);
    judge(&oscillator, &solution, &at, 0.05).unwrap_or_else(|error| panic!("{equation}: {error}"))
}

/// Everything that moves has its true motion near by, as stable, and the second order is nearer to
/// the largest than the first.
fn are_the_true_ones(equation: &str, resonance: (u32, u32), at: &str, within: f64) {
    let orders = [1, 2].map(|order| judged(equation, resonance, order, at));
    for judged in &orders {
        assert!(!judged.steady_states.is_empty(), "{equation} {at}");
        for state in &judged.steady_states {
            let near = state.state.amplitude == 0.0
                || state.relative_error.is_some_and(|error| error.abs() < within);
            assert!(
                near && state.true_stable == Some(state.state.is_stable()),
                "{equation} {at}: {state:?}"
            );
        }
    }
    let [first, second] = orders.map(|judged| judged.max_deviation.expect("a motion"));
    assert!(second < 0.5 * first, "{equation} {at}: {first} {second}");
}

#[test]
fn drives_whose_frequencies_have_a_ratio_act_together() {
    for (equation, resonance, at) in [
        // A force, and the parametric drive of twice its frequency.
        (
            "x'' + 2*zeta*x' + (1 + h*cos(2*w*t))*x + eps*x^3 = F*cos(w*t)",
            (1, 1),
            "zeta = 1/50, h = 1/50, eps = 1/20, F = 1/50, w = 101/100",
        ),
        // A second force far from resonance, and one at twice the frequency.
        (
            "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(w*t) + G*sin(3*w*t)",
            (1, 1),
            "zeta = 1/50, eps = 1/20, F = 1/50, G = 1, w = 1",
        ),
        (
            "x'' + 2*zeta*x' + x + b*x^2 = F*cos(w*t) + G*cos(2*w*t)",
            (1, 1),
            "zeta = 1/50, b = 1/50, F = 1/50, G = 1/2, w = 1",
        ),
        // Neither is in resonance, their difference is.
        (
            "x'' + 2*zeta*x' + x + b*x^2 = F*cos(2*w*t) + G*cos(3*w*t)",
            (1, 1),
            "zeta = 1/50, b = 1/20, F = 1, G = 1, w = 1",
        ),
    ] {
        are_the_true_ones(equation, resonance, at, 0.1);
    }
}

/// The slow equations of a force beside the principal parametric resonance are the sums of both.
#[test]
fn slow_equations_of_both_drives_are_their_sum() {
    let rates = |equation: &str, resonance: (u32, u32)| {
        let (_, solution) = derived(equation, Some(resonance), Some(1));
        solution.modulation.expect("slow equations").amplitude_rate
    };
    let both = rates("x'' + (1 + h*cos(2*w*t))*x + eps*x^3 = F*cos(w*t)", (1, 1));
    let expected: Expr = "F*sin(psi)/2 - h*a*sin(2*psi)/4".parse().expect("an expression");
    assert!((&both - &expected).expand().expect("short").is_zero(), "{both}");
}

#[test]
fn frequencies_without_a_ratio_are_refused_by_name() {
    let oscillator =
        Oscillator::parse("x'' + x + x^3 = F*cos(W*t) + G*cos(V*t)").expect("an oscillator");
    let refusal = solve(&oscillator, &Options::default()).expect_err("no ratio");
    assert!(refusal.term().is_some_and(|term| term.contains("cos(V*t)")), "{refusal}");
}

/// A base that moves: the answer is in the relative coordinate and says so, and the true motion of
/// that agrees.
#[test]
fn a_base_that_moves_is_left_out_of_the_force() {
    for (equation, at) in [
        ("x'' + x + eps*(x - Y*sin(w*t))^3 = 0", "eps = 1/10, Y = 1/5, w = 6/5"),
        (
            "x'' + 2*zeta*(x' - Y*w*cos(w*t)) + (x - Y*sin(w*t)) + eps*(x - Y*sin(w*t))^3 = 0",
            "zeta = 1/50, eps = 1/20, Y = 1/50, w = 101/100",
        ),
        ("x'' + 2*zeta*x' + sin(x - Y*cos(w*t)) = 0", "zeta = 1/50, Y = 1/50, w = 99/100"),
    ] {
        let (oscillator, solution) = derived(equation, Some((1, 1)), None);
        let said = |note: &Note| matches!(note, Note::RelativeCoordinate { .. });
        assert!(solution.validity.iter().any(said), "{equation}");
        assert_eq!(solution.coordinate().name(), "z");
        let judged = judge(&oscillator, &solution, &at.parse().expect(at), 0.2).expect(equation);
        let moving: Vec<_> =
            judged.steady_states.iter().filter_map(|state| state.relative_error).collect();
        assert!(
            !moving.is_empty() && moving.iter().all(|error| error.abs() < 0.2),
            "{equation}: {moving:?}"
        );
    }
}

/// Seen from one of two bases the other moves, and the first again as seen from that: there is an
/// end to it.
#[test]
fn bases_that_move_differently_are_refused() {
    for equation in [
        "x'' + x + eps*abs(x - t)*abs(x + t) = 0",
        "x'' + x + eps*sqrt(x - t)*sqrt(x + t) = 0",
        "x'' + x + eps*sin(x - t^2)*sin(x + t) = 0",
        "x'' + x + eps*abs(x' - cos(t))*abs(x' - cos(2*t))*abs(x - sin(3*t)) = 0",
        "x'' + x + eps*sqrt(x - cos(t))*sqrt(x - cos(V*t))*sqrt(x - t) = 0",
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        for method in Method::ALL {
            let options = Options { method: Some(method), ..Options::default() };
            let refusal = solve(&oscillator, &options).expect_err(equation);
            assert!(refusal.term().is_some(), "{equation}: {refusal}");
        }
        let default = solve(&oscillator, &Options::default()).expect_err(equation);
        assert!(default.term().is_some(), "{equation}: {default}");
    }
}

/// Beside a fifth power damping, detuning and drive count as the fourth power of the amplitude:
/// there are steady motions, and their error vanishes as the next power does.
#[test]
fn a_fifth_power_balances_at_its_own_order() {
    let equation = "x'' + x'/50 + x + x^5/10 = cos(Omega*t)/20";
    let judged = judged(equation, (1, 1), 4, "Omega = 51/50");
    assert_eq!(judged.verdict, Verdict::Pass, "{judged:?}");
    let slope = judged.slope.expect("a slope");
    assert!((3.5..6.0).contains(&slope), "{slope}");
    let (_, solution) = derived(equation, Some((1, 1)), None);
    assert_eq!(solution.order, 4);
    let law = solution.law.frequency().expect("a backbone").to_string();
    assert_eq!(law, "1 + a^4/32");
}

/// To first order in the amplitude nothing holds a damped motion: the order that does is named.
#[test]
fn an_order_at_which_nothing_holds_the_motion_is_refused() {
    let oscillator =
        Oscillator::parse("x'' + 2*zeta*x' + x + b*x^2 = F*cos(Omega*t)").expect("an oscillator");
    let options = Options {
        method: Some(Method::MultipleScales),
        small: Some("A".to_owned()),
        order: Some(1),
        resonance: Some((1, 2)),
        ..Options::default()
    };
    let refusal = solve(&oscillator, &options).expect_err("nothing holds it");
    assert!(refusal.to_string().contains("needs order 2"), "{refusal}");
    let held = Options { order: Some(2), ..options };
    let solution = solve(&oscillator, &held).expect("an answer");
    assert!(solution.response.is_some_and(|response| response.relation.is_some()));
}

/// The amplitude with which the true motion swings at a frequency, once what was free has died out,
/// by Runge-Kutta and the mean of the motion beside that wave under a window that lets no other
/// frequency through.
fn true_line(
    force: impl Fn(f64, f64, f64) -> f64,
    frequency: f64,
    [dies_out, window]: [f64; 2],
) -> f64 {
    const STEP: f64 = 0.02;
    let (mut t, mut x, mut v) = (0.0, 0.0, 0.0);
    let (mut cosine, mut sine, mut whole) = (0.0, 0.0, 0.0);
    while t < dies_out + window {
        let rate = |t: f64, x: f64, v: f64| (v, -force(t, x, v));
        let a = rate(t, x, v);
        let b = rate(t + STEP / 2.0, x + STEP / 2.0 * a.0, v + STEP / 2.0 * a.1);
        let c = rate(t + STEP / 2.0, x + STEP / 2.0 * b.0, v + STEP / 2.0 * b.1);
        let d = rate(t + STEP, x + STEP * c.0, v + STEP * c.1);
        x += STEP / 6.0 * (a.0 + 2.0 * b.0 + 2.0 * c.0 + d.0);
        v += STEP / 6.0 * (a.1 + 2.0 * b.1 + 2.0 * c.1 + d.1);
        t += STEP;
        if t > dies_out {
            let weight = (std::f64::consts::PI * (t - dies_out) / window).sin().powi(4);
            cosine += weight * x * (frequency * t).cos();
            sine += weight * x * (frequency * t).sin();
            whole += weight;
        }
    }
    2.0 * (cosine * cosine + sine * sine).sqrt() / whole
}

/// Drives of unrelated frequencies: beside the one near the linear frequency the others shift that
/// by 3*eps*Lambda^2 each, as Nayfeh and Mook have it, and the steady motion is the true one up to
/// a part that halves with all that is small.
#[test]
fn drives_without_a_ratio_act_together() {
    let duffing = "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(W*t) + G*cos(V*t)";
    let (_, solution) = derived(duffing, None, None);
    let slow = solution.modulation.as_ref().expect("slow equations");
    let resonance = slow.resonance.as_ref().expect("a drive");
    let near = resonance.driving_frequency.to_string();
    assert!(["V", "W"].contains(&near.as_str()), "{near}");
    let (weak, strong, far) = if near == "W" { ("F", "G", "V") } else { ("G", "F", "W") };
    let rate: Expr = format!("sigma - 3*eps*a^2/8 - 3*eps*Lambda^2 + {weak}*cos(psi)/(2*a)")
        .parse()
        .expect("a rate");
    assert!((&slow.phase_rate - &rate).expand().expect("short").is_zero(), "{}", slow.phase_rate);
    let size: Expr = format!("{strong}/(2*(1 - {far}^2))").parse().expect("a size");
    let lambda = solution.definitions.iter().find(|own| own.symbol == Symbol::new("Lambda"));
    assert_eq!(lambda.expect("Lambda").meaning, size);
    let error = |eps: f64| {
        let (zeta, weak_size, strong_size) = (0.5 * eps, eps, 3.0);
        let (near_rate, far_rate) = (1.0 + 0.6 * eps, 2.0_f64.sqrt() + 0.6);
        let number = |name: Symbol| {
            Some(match name.name() {
                "zeta" => zeta,
                "eps" => eps,
                name if name == weak => weak_size,
                name if name == strong => strong_size,
                name if name == near => near_rate,
                name if name == far => far_rate,
                _ => return None,
            })
        };
        let states = solution.steady_states(&number);
        let [only] = states.as_slice() else { panic!("{states:?}") };
        let force = |t: f64, x: f64, v: f64| {
            let drives = weak_size * (near_rate * t).cos() + strong_size * (far_rate * t).cos();
            2.0 * zeta * v + x + eps * x.powi(3) - drives
        };
        let truth = true_line(force, near_rate, [16.0 / zeta, 400.0]);
        only.amplitude / truth - 1.0
    };
    let [coarse, fine] = [0.04, 0.02].map(error);
    assert!(coarse.abs() < 0.08 && fine.abs() < 0.6 * coarse.abs(), "{coarse} {fine}");
    // Without a period there is no verdict.
    let oscillator = Oscillator::parse(duffing).expect("an oscillator");
    let at: Values =
        "zeta = 1/50, eps = 1/25, F = 1/25, G = 3, W = 1.02, V = 2.01".parse().expect("values");
    assert_eq!(judge(&oscillator, &solution, &at, 0.01), Err(VerificationError::NeverRepeats));
}

/// Of drives with numbers the nearest to the linear frequency is the one in resonance; what is
/// missing is refused.
#[test]
fn drives_without_a_ratio_say_which_is_near() {
    let near = |equation: &str| {
        let (_, solution) = derived(equation, None, None);
        let notes = solution.validity.iter();
        notes
            .filter_map(|note| match note {
                Note::ForcedWaves { near, far } => Some((near.to_string(), far.len())),
                _ => None,
            })
            .next()
    };
    let one = |near: &str, far: usize| Some((near.to_owned(), far));
    assert_eq!(
        near("x'' + 2*zeta*x' + x + eps*x^3 = F*cos(sqrt(2)*t) + G*cos(21*t/20)"),
        one("21/20", 1)
    );
    assert_eq!(near("x'' + 2*eps*z*x' + x + eps*x^3 = F*cos(W*t) + eps*G*cos(Z*t)"), one("Z", 1));
    assert_eq!(
        near("x'' + 2*zeta*x' + x + eps*x^3 = F*cos(U*t) + G*cos(V*t) + H1*sin(W*t)")
            .map(|found| found.1),
        Some(2)
    );
    for equation in [
        "x'' + 2*zeta*x' + x + x^3 = F*cos(W*t) + G*cos(V*t)",
        "x'' + 2*zeta*x' + x + eps*x^2 + eps*x^3 = F*cos(W*t) + G*cos(V*t)",
        "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(W*t) + G*x*cos(V*t)",
        "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(sqrt(2)*t) + G*cos(3*t)",
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let refusal = solve(&oscillator, &Options::default()).expect_err(equation).to_string();
        assert!(
            refusal.contains("drives whose frequencies are small multiples of one"),
            "{refusal}"
        );
    }
}

//! Branches of limit cycles against what is known of them otherwise: closed forms, printed numbers,
//! the return map.

use lindstedt::numeric::return_map::{
    AutonomousEquation, NumericalLimitCycle, nearest_limit_cycle,
};
use lindstedt::response::bifurcation::BifurcationKind;
use lindstedt::response::continuation::BranchEnd;
use lindstedt::response::{ResponseDiagram, ResponseRequest, SteadyMotion, respond};
use lindstedt::verify::Verdict;

fn question(equation: &str, parameter: &str, range: [f64; 2], values: &str) -> ResponseRequest {
    ResponseRequest::new(equation, parameter, range, values).expect(equation)
}

fn response(equation: &str, parameter: &str, range: [f64; 2]) -> ResponseDiagram {
    respond(&question(equation, parameter, range, "")).expect(equation)
}

fn points(response: &ResponseDiagram) -> impl Iterator<Item = &SteadyMotion> {
    response.branches.iter().flat_map(|branch| &branch.points)
}

fn kinds(response: &ResponseDiagram, kind: BifurcationKind) -> Vec<f64> {
    let of_kind = response.bifurcations.iter().filter(|found| found.kind == kind);
    of_kind.map(|found| found.parameter).collect()
}

/// The cycle that the return map finds near this amplitude: another way, by other code.
fn returned(
    acceleration: &dyn Fn(f64, f64) -> f64,
    amplitude: f64,
    attracts: bool,
) -> Option<NumericalLimitCycle> {
    let equation = AutonomousEquation { acceleration, equilibrium: 0.0, amplitude, frequency: 1.0 };
    let found = nearest_limit_cycle(&equation, Some(attracts)).ok()?;
    (found.attracts() == attracts && (found.phase_point_at(0.0).0 / amplitude - 1.0).abs() < 0.05)
        .then_some(found)
}

/// On x = cos t the damping is zero, its derivative by the velocity has the mean mu.
#[test]
fn a_circle_is_exact() {
    let found = response("x'' + mu*(x^2 + x'^2 - 1)*x' + x = 0", "mu", [0.05, 1.5]);
    assert_eq!((found.branches.len(), found.verdict), (1, Verdict::Pass));
    assert!(found.self_excited && found.simulated.len() > 3 && found.bifurcations.is_empty());
    for point in points(&found) {
        let [decides, along] = point.multipliers.expect("multipliers");
        let expected = (-std::f64::consts::TAU * point.parameter).exp();
        assert!((point.amplitude - 1.0).abs() < 1e-9 && (point.frequency - 1.0).abs() < 1e-9);
        assert!((decides.re / expected - 1.0).abs() < 1e-7 && along.re == 1.0, "{point:?}");
        assert_eq!(point.stable, Some(true));
    }
    // Against time it repels.
    let found = response("x'' - mu*(x^2 + x'^2 - 1)*x' + x = 0", "mu", [0.05, 1.5]);
    for point in points(&found) {
        let decides = point.multipliers.expect("multipliers")[0].re;
        let expected = (std::f64::consts::TAU * point.parameter).exp();
        assert!(
            (decides / expected - 1.0).abs() < 1e-7 && point.stable == Some(false),
            "{point:?}"
        );
    }
}

/// Printed numbers of van der Pol's oscillator, peaks and periods: M. Urabe, *IRE Trans. Circuit
/// Theory* 7 (1960) 382.
#[test]
fn van_der_pol_has_its_printed_amplitude_and_period() {
    let found = respond(&ResponseRequest {
        harmonics: Some(64),
        ..question("x'' - mu*(1 - x^2)*x' + x = 0", "mu", [1.0, 5.0], "")
    })
    .expect("a response");
    assert_eq!((found.branches.len(), found.verdict), (1, Verdict::Pass));
    for (mu, peak, period) in [(1.0, 2.00862, 6.66329), (5.0, 2.02151, 11.6122)] {
        let point = points(&found).find(|point| point.parameter == mu).expect("an end");
        assert!((std::f64::consts::TAU / point.frequency - period).abs() < 1e-3, "{point:?}");
        assert!((point.peak - peak).abs() < 4e-4 && point.stable == Some(true), "{point:?}");
    }
}

#[test]
fn two_cycles_meet_in_a_fold_and_one_is_born_from_rest() {
    let found = respond(&ResponseRequest {
        harmonics: Some(20),
        ..question("x'' + (mu - x^2 + x^4)*x' + x = 0", "mu", [-0.1, 0.2], "")
    })
    .expect("a response");
    assert_eq!(found.verdict, Verdict::Pass);
    let [fold] = kinds(&found, BifurcationKind::Fold)[..] else {
        panic!("{:?}", found.bifurcations)
    };
    let [born] = kinds(&found, BifurcationKind::Hopf)[..] else {
        panic!("{:?}", found.bifurcations)
    };
    assert!(born.abs() < 1e-9 && found.branches[0].ends.contains(&BranchEnd::Rest));
    let damped = |mu: f64| move |x: f64, v: f64| -x - (mu - x * x + x.powi(4)) * v;
    let mut seen = [0, 0];
    // Near the fold, and near rest, the return map is hardly more than what it is given.
    let clear = |point: &&SteadyMotion| {
        let decides = point.multipliers.expect("multipliers")[0].re;
        point.amplitude > 0.3 && (decides - 1.0).abs() > 0.2
    };
    for point in points(&found).filter(clear).step_by(5) {
        let attracts = point.stable == Some(true);
        let acceleration = damped(point.parameter);
        let cycle = returned(&acceleration, point.peak, attracts).expect("a cycle");
        assert!((cycle.phase_point_at(0.0).0 / point.peak - 1.0).abs() < 1e-4, "{point:?}");
        let period = std::f64::consts::TAU / point.frequency;
        assert!((cycle.period() / period - 1.0).abs() < 1e-5, "{point:?}");
        seen[usize::from(attracts)] += 1;
    }
    assert!(seen.iter().all(|count| *count > 2), "{seen:?}");
    // On this side of the fold the return map has its two fixed points, beyond it none.
    let both =
        |mu: f64| [true, false].map(|attracts| returned(&damped(mu), 1.0, attracts).is_some());
    assert_eq!((both(fold - 1e-5), both(fold + 1e-5)), ([true, true], [false, false]));
}

/// The multiplier is the slope of the return map at its fixed point.
#[test]
fn the_multiplier_is_the_slope_of_the_return_map() {
    use lindstedt::numeric::ode::{Event, IntegrationOptions, State, integrate};
    let found = response("x'' - mu*(x' - x'^3/3) + x + x^3/4 = 0", "mu", [0.1, 0.4]);
    for point in points(&found).step_by(7) {
        let mu = point.parameter;
        let acceleration =
            |_: f64, x: f64, v: f64| mu * (v - v.powi(3) / 3.0) - x - 0.25 * x.powi(3);
        let options = IntegrationOptions::with_tolerance(1e-12);
        let next = |x: f64| {
            let turning = Event::stop(|_, _, v| v).falling();
            let start = State { t: 0.0, x, v: 0.0 };
            integrate(acceleration, start, 100.0, &[turning], &options).expect("a path").end().x
        };
        let mut turn = point.peak;
        for _ in 0..60 {
            turn = next(turn);
        }
        let step = 1e-5;
        let slope = (next(turn + step) - next(turn - step)) / (2.0 * step);
        let multiplier = point.multipliers.expect("multipliers")[0].re;
        assert!((multiplier / slope - 1.0).abs() < 1e-3, "{mu}: {multiplier} {slope}");
    }
}

/// Liénard: where the damping is no function of the side, motions of every amplitude at mu = 0.
#[test]
fn without_damping_there_is_a_centre_and_no_branch_of_it() {
    let found = response("x'' - mu*(1 - x^2)*x' + x = 0", "mu", [-1.0, 1.0]);
    let [centre] = kinds(&found, BifurcationKind::Centre)[..] else {
        panic!("{:?}", found.bifurcations)
    };
    assert!(centre.abs() < 1e-5 && found.branches.len() == 1);
    assert!(points(&found).all(|point| (point.stable == Some(true)) == (point.parameter > 0.0)));
}

/// The cycle swells until it touches the saddle at x = 1: its period has no bound, and what is not
/// judged is not shown.
#[test]
fn a_branch_ends_where_its_period_grows_without_bound() {
    let found = respond(&ResponseRequest {
        harmonics: Some(64),
        ..question("x'' - mu*x' + x*x' + x - x^2 = 0", "mu", [-0.5, 0.5], "")
    })
    .expect("a response");
    let branch = &found.branches[0];
    assert!(branch.ends.contains(&BranchEnd::Slow) && found.verdict == Verdict::Pass);
    let slowest = points(&found).map(|point| point.frequency).fold(1.0, f64::min);
    assert!(slowest < 0.2 && points(&found).all(|point| point.peak < 0.8));
    assert!(kinds(&found, BifurcationKind::Hopf)[0].abs() < 1e-9);
}

/// Lengths and times of any unit.
#[test]
fn units_do_not_matter() {
    let found = response("x'' - 50*mu*(1 - x^2/400)*x' + 2500*x = 0", "mu", [0.5, 1.0]);
    let last = points(&found).find(|point| point.parameter == 1.0).expect("an end");
    assert!(
        (last.peak / 20.0 - 2.00862).abs() < 1e-3
            && (last.frequency / 50.0 * 6.66329 / std::f64::consts::TAU - 1.0).abs() < 1e-4
    );
}

#[test]
fn what_does_not_swing_by_itself_is_refused() {
    for (equation, words) in [
        ("x'' + k*x + x^3 = 0", "there is no drive: time"),
        ("x'' + k*x' + x = 0", "no limit cycle was found for k from 0.5 to 2"),
        ("x'' + k*x' + x^3 + x'^3 = 0", "no limit cycle"),
    ] {
        let refused = respond(&question(equation, "k", [0.5, 2.0], "")).expect_err(equation);
        assert!(refused.to_string().contains(words), "{equation}: {refused}");
    }
    let refused = respond(&ResponseRequest {
        periods: 2,
        ..question("x'' - mu*(1 - x^2)*x' + x = 0", "mu", [0.5, 1.0], "")
    });
    assert!(refused.expect_err("periods").to_string().contains("2 periods"));
}

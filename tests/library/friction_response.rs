//! Steady states under dry friction against Den Hartog's closed form, simulation piece by piece,
//! and differences of its map.

use lindstedt::numeric::ode::{IntegrationOptions, Point, integrate_first_order};
use lindstedt::response::bifurcation::BifurcationKind;
use lindstedt::response::continuation::BranchEnd;
use lindstedt::response::{Criticality, ResponseDiagram, ResponseRequest, SteadyMotion, respond};
use lindstedt::trajectory::TrajectoryRequest;
use lindstedt::verify::Verdict;
use lindstedt::{Oscillator, Symbol};

fn response(equation: &str, range: [f64; 2], values: &str, harmonics: usize) -> ResponseDiagram {
    let question = ResponseRequest::new(equation, "Omega", range, values).expect(equation);
    respond(&ResponseRequest { harmonics: Some(harmonics), ..question }).expect(equation)
}

fn points(response: &ResponseDiagram) -> impl Iterator<Item = &SteadyMotion> {
    response.branches.iter().flat_map(|branch| &branch.points)
}

/// Position and velocity after a period, by the simulation that takes every term of `sgn` at its
/// events.
fn after_a_period(
    equation: &str,
    numbers: &[(&str, f64)],
    start: [f64; 2],
    period: f64,
) -> [f64; 2] {
    let mut course = TrajectoryRequest::of_equation(&Oscillator::parse(equation).expect(equation));
    course.values = numbers.iter().map(|(name, value)| (Symbol::new(name), *value)).collect();
    course.begin("x".into(), start[0]).expect("a state");
    course.begin("x'".into(), start[1]).expect("a state");
    (course.duration, course.tolerance) = (period, 1e-12);
    let state = course.follow().expect("a motion").states_at(period).expect("a state");
    [state[0], state[1]]
}

/// J. P. Den Hartog, *Trans. ASME* 53 (1931) APM-107: the largest displacement of motions that do
/// not stop, with r = Omega.
#[test]
fn motions_that_do_not_stop_are_those_of_den_hartog() {
    let found =
        response("x'' + x + alpha*sgn(x') = F*cos(Omega*t)", [1.2, 2.0], "F = 1, alpha = 1/5", 24);
    assert_eq!((found.branches.len(), found.verdict, found.unjudged), (1, Verdict::Pass, 0));
    assert!(found.jumps && found.simulated.len() > 3);
    for point in points(&found) {
        let r = point.parameter;
        let response = 1.0 / (1.0 - r * r);
        let angle = std::f64::consts::PI / r;
        let friction = angle.sin() / (r * (1.0 + angle.cos()));
        let peak = (response.powi(2) - (0.2 * friction).powi(2)).sqrt();
        assert!((point.peak / peak - 1.0).abs() < 2e-3, "{r}: {} {peak}", point.peak);
        assert_eq!(point.stable, Some(true));
    }
}

/// The multipliers are the eigenvalues of the map of a period, its derivatives by differences of
/// the simulation.
#[test]
fn multipliers_across_a_jump_are_those_of_the_map() {
    for (equation, range) in [
        ("x'' + x'/10 + x + x^3/5 + alpha*sgn(x') = F*cos(Omega*t)", [1.3, 1.8]),
        ("x'' + x'/10 + x + alpha*x*H(x') = F*cos(Omega*t)", [1.4, 1.8]),
        ("x'' + x'/10 + x + alpha*sgn(x' - 1/10) = F*cos(Omega*t)", [1.4, 1.8]),
        // A step in place, a slanted line, two velocities, place and velocity: by the map alone.
        ("x'' + x'/10 + x + alpha*sgn(x) = F*cos(Omega*t)", [1.5, 1.8]),
        ("x'' + x'/10 + x + alpha*H(x' + x/2 - 1/10)*x^2 = F*cos(Omega*t)", [1.5, 1.8]),
        ("x'' + x'/10 + x + alpha*(sgn(x') + sgn(x' - 1/2))/2 = F*cos(Omega*t)", [1.5, 1.8]),
        ("x'' + x'/10 + x + alpha*(sgn(x') + H(x - 1/5)/3) = F*cos(Omega*t)", [1.5, 1.8]),
    ] {
        let found = response(equation, range, "F = 1, alpha = 1/5", 12);
        // However few the harmonics, the multipliers are those of the true motion beside them.
        assert_eq!(found.unjudged, 0, "{equation}: {:?}", found.error);
        let mut seen = 0;
        for point in points(&found).step_by(11) {
            let numbers = [("F", 1.0), ("alpha", 0.2), ("Omega", point.parameter)];
            let period = std::f64::consts::TAU / point.parameter;
            let map = |start: [f64; 2]| after_a_period(equation, &numbers, start, period);
            let [x, v] = point.start;
            let back = map(point.start);
            assert!((back[0] - x).hypot(back[1] - v) < 1e-6, "{equation}: {back:?} {point:?}");
            const STEP: f64 = 1e-4;
            let slope = |to: [f64; 2], from: [f64; 2]| {
                let (to, from) = (map(to), map(from));
                [(to[0] - from[0]) / (2.0 * STEP), (to[1] - from[1]) / (2.0 * STEP)]
            };
            let by_x = slope([x + STEP, v], [x - STEP, v]);
            let by_v = slope([x, v + STEP], [x, v - STEP]);
            let (trace, determinant) = (by_x[0] + by_v[1], by_x[0] * by_v[1] - by_v[0] * by_x[1]);
            let [one, other] = point.multipliers.expect("multipliers");
            assert!(((one + other).re - trace).abs() < 1e-3, "{equation}: {point:?} {trace}");
            assert!(
                ((one * other).re - determinant).abs() < 1e-3,
                "{equation}: {point:?} {determinant}"
            );
            seen += 1;
        }
        assert!(seen > 1, "{equation}");
    }
}

/// What sticks forgets: a multiplier is zero, and a simulation from beside it is on the motion
/// after a stop.
#[test]
fn a_motion_that_sticks_has_a_multiplier_of_zero() {
    use lindstedt::numeric::ode::IntegrationOptions;
    use lindstedt::response::driven::Driven;
    use lindstedt::response::jump::{StopCondition, follow};
    let equation = "x'' + x + 3/5*sgn(x') = cos(k*t)";
    let oscillator = Oscillator::parse(equation).expect(equation);
    let driven = Driven::new(&oscillator, "k".into(), 1).expect(equation);
    let (k, period) = (0.5, 4.0 * std::f64::consts::PI);
    let mut start = [0.5, 0.0];
    for _ in 0..6 {
        let course = follow(
            &driven,
            start,
            k,
            StopCondition::Time(period),
            &IntegrationOptions::with_tolerance(1e-11),
        )
        .expect("a motion");
        let [x, v, a, c, b, d] = course.end;
        assert!((a * d - b * c).abs() < 1e-12);
        let expected = after_a_period("x'' + x + 3/5*sgn(x') = cos(t/2)", &[], start, period);
        assert!(
            (x - expected[0]).abs() < 1e-7 && (v - expected[1]).abs() < 1e-7,
            "{course:?} {expected:?}"
        );
        start = [x, v];
    }
}

/// A motion under dry friction alone that does not stop, `x = alpha + V F cos(W t) + ...` down from
/// one turning point to the other: the largest displacement X, and W^2 X - alpha, which is positive
/// as long as it does not rest at the turn (Den Hartog, as above).
fn without_a_stop(r: f64, alpha: f64) -> (f64, f64) {
    let response = 1.0 / (1.0 - r * r);
    let friction = (0.5 * std::f64::consts::PI / r).tan() / r;
    let peak = (response.powi(2) - (alpha * friction).powi(2)).sqrt();
    (peak, r * r * peak - alpha)
}

/// Below the frequency at which Den Hartog's motion would rest at its turns the branch goes on with
/// motions that stick: each the fixed point of the simulation that knows nothing of the branch,
/// with a multiplier of zero.
#[test]
fn a_branch_goes_on_where_the_motion_begins_to_stick() {
    let equation = "x'' + x + alpha*sgn(x') = F*cos(Omega*t)";
    let found = response(equation, [0.35, 0.85], "F = 1, alpha = 1/2", 24);
    assert_eq!((found.branches.len(), found.unjudged), (1, 0), "{:?}", found.branches);
    let (mut low, mut high) = (0.5, 0.7);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match without_a_stop(middle, 0.5).1 < 0.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    let mut sticking = 0;
    for (index, point) in points(&found).enumerate() {
        let r = point.parameter;
        assert_eq!(point.stuck > 0.0, r < low, "{r}: {} {low}", point.stuck);
        assert_eq!(point.stable, Some(true), "{point:?}");
        if point.stuck == 0.0 {
            let (peak, _) = without_a_stop(r, 0.5);
            // Waves are slow to come near; the error that stands beside them is theirs.
            let error = point.error.expect("an error");
            assert!((point.peak / peak - 1.0).abs() < error + 1e-6, "{r}: {} {peak}", point.peak);
            continue;
        }
        sticking += 1;
        let [one, other] = point.multipliers.expect("multipliers");
        assert!(one.norm() < 1.0 && other.norm() < 1e-9, "{point:?}");
        if index % 9 == 0 {
            let numbers = [("F", 1.0), ("alpha", 0.5), ("Omega", r)];
            let back = after_a_period(equation, &numbers, point.start, std::f64::consts::TAU / r);
            assert!(
                (back[0] - point.start[0]).hypot(back[1] - point.start[1]) < 1e-6,
                "{point:?} {back:?}"
            );
        }
    }
    assert!(sticking > 10);
}

/// Less force than friction bears moves nothing: the branch ends there, at rest.
#[test]
fn a_branch_ends_where_friction_bears_the_drive() {
    let question = ResponseRequest::new(
        "x'' + x'/20 + x + alpha*sgn(x') = F*cos(7/10*t)",
        "F",
        [0.2, 2.0],
        "alpha = 1/2",
    );
    let question = ResponseRequest { harmonics: Some(12), ..question.expect("a question") };
    let found = respond(&question).expect("a response");
    let [branch] = &found.branches[..] else { panic!("one branch: {:?}", found.branches) };
    let ends = [(branch.ends[0], branch.points.first()), (branch.ends[1], branch.points.last())];
    let held = ends.iter().find(|(end, _)| *end == BranchEnd::Held).and_then(|(_, point)| *point);
    let last = held.expect("an end at rest");
    assert!((0.5..0.52).contains(&last.parameter) && last.stuck > 0.8, "{last:?}");
    assert!(branch.points.iter().any(|point| point.parameter > 1.99 && point.stuck == 0.0));
}

/// Dry friction that damps and a damper that feeds: a cycle that repels, in closed form from one
/// turn to the next, `X = c (q + 1)/(q - 1)` with `q = e^(pi/sqrt 3)` and the multiplier q^2.
#[test]
fn a_cycle_across_a_jump_is_that_of_its_half_swings() {
    let question = ResponseRequest::new("x'' + c*sgn(x') - x' + x = 0", "c", [0.1, 1.0], "")
        .expect("a question");
    let found = respond(&question).expect("a response");
    assert!(found.by_map && found.branches.len() == 1 && found.unjudged == 0);
    let growth = (std::f64::consts::PI / 3.0_f64.sqrt()).exp();
    for point in points(&found) {
        let turn = point.parameter * (growth + 1.0) / (growth - 1.0);
        assert!((point.start[0] / turn - 1.0).abs() < 1e-8, "{point:?} {turn}");
        let multiplier = point.multipliers.expect("multipliers")[0].re;
        assert!((multiplier / growth.powi(2) - 1.0).abs() < 1e-6, "{multiplier}");
        assert!(
            (point.frequency / 0.75_f64.sqrt() - 1.0).abs() < 1e-9 && point.stable == Some(false)
        );
    }
}

/// A mass on a belt whose friction falls with the speed of sliding: it sticks and slips, with a
/// multiplier of zero, until the belt is fast enough; beside it a cycle that only slips repels,
/// born from rest where the friction falls no faster than the damper bears.
#[test]
fn a_mass_on_a_belt_sticks_and_slips() {
    let friction = "3/10*sgn(x' - v)*(1 + exp(-10*abs(x' - v))/2)";
    let equation = format!("x'' + x'/50 + x + {friction} = 0");
    let found = respond(&ResponseRequest::new(&equation, "v", [0.1, 1.0], "").expect("a question"))
        .expect("a response");
    assert_eq!((found.branches.len(), found.verdict), (2, Verdict::Pass), "{:?}", found.error);
    for (index, branch) in found.branches.iter().enumerate() {
        let sticks = branch.points[branch.points.len() / 2].stuck > 0.0;
        for point in branch.points.iter().step_by(25).filter(|point| point.peak > 1e-3) {
            assert_eq!(
                (point.stuck > 0.0, point.stable),
                (sticks, Some(sticks)),
                "{index}: {point:?}"
            );
            let period = std::f64::consts::TAU / point.frequency;
            let back = after_a_period(&equation, &[("v", point.parameter)], point.start, period);
            assert!(
                (back[0] - point.start[0]).abs() < 1e-6 && back[1].abs() < 1e-6,
                "{point:?} {back:?}"
            );
            if sticks {
                assert!(point.multipliers.expect("multipliers")[0].norm() < 1e-8, "{point:?}");
            }
        }
    }
    // 1/50 = (3/10) 5 e^(-10 v).
    let born = 0.1 * (0.3_f64 * 5.0 * 50.0).ln();
    let hopf: Vec<f64> = found.bifurcations.iter().map(|found| found.parameter).collect();
    assert!(hopf.iter().any(|parameter| (parameter - born).abs() < 1e-6), "{hopf:?} {born}");
}

/// A motion that crosses a jump of the force loses its stability to one of twice the period, which is called
/// supercritical. Integrated here, the distance of the motions after one period and after two grows with the
/// root of that from the point, on the side on which the old motion is unstable.
#[test]
fn a_period_doubling_across_a_jump_is_supercritical() {
    let text = "x'' + x'/10 + x^3 + sgn(x)/5 = F*cos(t)";
    let found = respond(&ResponseRequest::new(text, "F", [4.5, 6.0], "").expect(text)).expect(text);
    let changes = found.bifurcations.iter();
    let changes = changes.filter(|change| change.kind == BifurcationKind::PeriodDoubling);
    let changes: Vec<_> = changes.collect();
    let [change] = changes[..] else { panic!("{changes:?}") };
    assert_eq!(change.criticality, Some(Criticality::Supercritical));
    let apart = |force: f64| {
        let near = found.branches[change.branch].points.iter();
        let near = near.filter(|point| (point.peak - change.peak).abs() < 0.1 * change.peak);
        let distance = |point: &&SteadyMotion| (point.parameter - force).abs();
        let nearest = near.min_by(|one, two| distance(one).total_cmp(&distance(two)));
        let mut state = nearest.expect("a point").start;
        state[0] += 0.01;
        let rates = |t: f64, [x, v]: &[f64; 2], out: &mut [f64; 2]| {
            *out = [*v, force * t.cos() - v / 10.0 - x.powi(3) - x.signum() / 5.0];
        };
        let mut before = state;
        for _ in 0..1200 {
            before = state;
            let options = IntegrationOptions::with_tolerance(1e-8);
            let begin = Point { t: 0.0, y: state };
            let path = integrate_first_order(rates, begin, std::f64::consts::TAU, &[], &options);
            state = path.expect("a path").end().y;
        }
        (state[0] - before[0]).hypot(state[1] - before[1])
    };
    let [stable, near, far] = [-0.05, 0.03, 0.06].map(|aside| apart(change.parameter + aside));
    assert!(stable < 1e-4 && (1.3..1.55).contains(&(far / near)), "{stable} {near} {far}");
}

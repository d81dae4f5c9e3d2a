//! Steady states against what is known of them otherwise: closed forms, simulation by Taylor
//! series, Liouville's theorem.

use lindstedt::numeric::ode::{IntegrationOptions, Point, integrate_first_order};
use lindstedt::response::bifurcation::BifurcationKind;
use lindstedt::response::continuation::BranchEnd;
use lindstedt::response::{Bifurcation, ResponseDiagram, ResponseRequest, SteadyMotion, respond};
use lindstedt::solution::AmplitudeConvention;
use lindstedt::trajectory::TrajectoryRequest;
use lindstedt::verify::Verdict;
use lindstedt::{Oscillator, Symbol, solve};

fn question(equation: &str, parameter: &str, range: [f64; 2], values: &str) -> ResponseRequest {
    ResponseRequest::new(equation, parameter, range, values).expect(equation)
}

fn response(equation: &str, parameter: &str, range: [f64; 2], values: &str) -> ResponseDiagram {
    respond(&question(equation, parameter, range, values)).expect(equation)
}

const DUFFING: &str = "x'' + c*x' + x + x^3 - F*cos(Omega*t) = 0";

fn duffing() -> ResponseDiagram {
    response(DUFFING, "Omega", [0.5, 2.5], "c = 1/10, F = 3/10")
}

fn places(response: &ResponseDiagram, kind: BifurcationKind) -> Vec<Bifurcation> {
    let of_kind = response.bifurcations.iter().filter(|found| found.kind == kind);
    of_kind.copied().collect()
}

/// The points of all branches nearest to a value of the parameter, one for each time that a branch
/// passes it.
fn passing(response: &ResponseDiagram, parameter: f64) -> Vec<SteadyMotion> {
    let mut found = Vec::new();
    for branch in &response.branches {
        for pair in branch.points.windows(2) {
            let between = (pair[0].parameter - parameter) * (pair[1].parameter - parameter);
            if between <= 0.0 && pair[0].parameter != pair[1].parameter {
                let nearer = pair.iter().min_by(|one, other| {
                    let distance = |point: &SteadyMotion| (point.parameter - parameter).abs();
                    distance(one).total_cmp(&distance(other))
                });
                found.extend(nearer.cloned());
            }
        }
    }
    found
}

/// The equation by its Taylor series, or piece by piece, which shares nothing with the balance:
/// position and velocity after so many periods, and the amplitude of the first harmonic and half of
/// peak to peak of the last one.
fn simulated(
    equation: &str,
    numbers: &[(&str, f64)],
    start: [f64; 2],
    period: f64,
    periods: u32,
) -> ([f64; 2], f64, f64) {
    let mut course = TrajectoryRequest::of_equation(&Oscillator::parse(equation).expect(equation));
    let end = f64::from(periods) * period;
    course.values = numbers.iter().map(|(name, value)| (Symbol::new(name), *value)).collect();
    course.begin("x".into(), start[0]).expect("a state");
    course.begin("x'".into(), start[1]).expect("a state");
    (course.duration, course.tolerance) = (end, 1e-12);
    let path = course.follow().expect("a motion");
    assert!(path.is_complete(), "{equation}");
    const SAMPLES: u32 = 512;
    let sample = |index: u32| end - period + period * f64::from(index) / f64::from(SAMPLES);
    let positions: Vec<f64> =
        (0..SAMPLES).map(|index| path.states_at(sample(index)).expect("a state")[0]).collect();
    let sum = |wave: fn(f64) -> f64| {
        let phase = |index: usize| std::f64::consts::TAU * index as f64 / f64::from(SAMPLES);
        let terms = positions.iter().enumerate().map(|(index, x)| x * wave(phase(index)));
        terms.sum::<f64>() * 2.0 / f64::from(SAMPLES)
    };
    let highest = positions.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = positions.iter().copied().fold(f64::INFINITY, f64::min);
    let state = path.states_at(end).expect("a state");
    ([state[0], state[1]], sum(f64::cos).hypot(sum(f64::sin)), 0.5 * (highest - lowest))
}

#[test]
fn a_linear_oscillator_is_exact() {
    let (c, force) = (0.2, 0.7);
    let found =
        response("x'' + c*x' + x - F*sin(Omega*t) = 0", "Omega", [0.3, 2.0], "c = 1/5, F = 7/10");
    assert_eq!(
        (found.branches.len(), found.bifurcations.len(), found.verdict),
        (1, 0, Verdict::Pass)
    );
    for point in &found.branches[0].points {
        let omega = point.parameter;
        let stiffness = 1.0 - omega * omega;
        let amplitude = force / stiffness.hypot(c * omega);
        let phase = (c * omega).atan2(stiffness) + std::f64::consts::FRAC_PI_2;
        let turned = (point.phase - phase).sin();
        assert!((point.amplitude / amplitude - 1.0).abs() < 1e-9, "{point:?}");
        assert!(turned.abs() < 1e-9 && (point.phase - phase).cos() > 0.0, "{point:?}");
        assert!((point.peak / amplitude - 1.0).abs() < 1e-4 && point.stable == Some(true));
        let [one, other] = point.multipliers.expect("multipliers");
        let decay = (-c * std::f64::consts::TAU / omega).exp();
        assert!(((one * other).re / decay - 1.0).abs() < 1e-7, "{point:?}");
    }
    let curve = &found.backbone[0];
    assert!(curve.iter().all(|point| (point.parameter - 1.0).abs() < 1e-9));
}

/// With one harmonic: `s ((1 - Omega^2 + 3 s/4)^2 + (c Omega)^2) = F^2` with s the square of the
/// amplitude, and at a fold its derivative by s is zero.
#[test]
fn folds_of_one_harmonic_are_those_of_the_closed_form() {
    let found = respond(&ResponseRequest {
        harmonics: Some(1),
        ..question(DUFFING, "Omega", [0.5, 2.5], "c = 1/10, F = 3/10")
    })
    .expect("a response");
    let folds = places(&found, BifurcationKind::Fold);
    assert_eq!(folds.len(), 2);
    for fold in folds {
        let (s, omega) = (fold.amplitude.powi(2), fold.parameter);
        let stiffness = 1.0 - omega * omega + 0.75 * s;
        let damping = (0.1 * omega).powi(2);
        let force = s * (stiffness * stiffness + damping);
        let slope = stiffness * stiffness + damping + 1.5 * s * stiffness;
        assert!((force - 0.09).abs() < 1e-9 && slope.abs() < 1e-6, "{fold:?}: {force} {slope}");
    }
    for point in &found.branches[0].points {
        let (s, omega) = (point.amplitude.powi(2), point.parameter);
        let stiffness = 1.0 - omega * omega + 0.75 * s;
        assert!((s * (stiffness * stiffness + (0.1 * omega).powi(2)) - 0.09).abs() < 1e-9);
    }
}

/// A linear oscillator has one motion; what of the beginning has not died out is none. A spring
/// without a linear part has motions of several periods there, which come back after so many periods
/// and no fewer, by Runge-Kutta.
#[test]
fn what_dies_out_slowly_is_no_motion_of_its_own() {
    for (equation, range) in [
        ("x'' + x'/50 + x = cos(Omega*t)/10", [2.0, 3.0]),
        ("x'' + x'/200 + x = cos(Omega*t)/10", [2.0, 3.0]),
        ("x'' + x'/50 + x + x^3/10 = cos(Omega*t)/10", [1.3, 1.4]),
    ] {
        let found = response(equation, "Omega", range, "");
        assert!(found.elsewhere.is_empty(), "{equation}: {:?}", found.elsewhere);
    }
    let found = response("x'' + x'/10 + x^3 = 3*cos(Omega*t)/10", "Omega", [1.0, 1.4], "");
    assert!(found.elsewhere.iter().any(|elsewhere| elsewhere.periods == Some(3)));
    for elsewhere in &found.elsewhere {
        let omega = elsewhere.parameter;
        let rates = |t: f64, y: &[f64; 2], rates: &mut [f64; 2]| {
            *rates = [y[1], -0.1 * y[1] - y[0].powi(3) + 0.3 * (omega * t).cos()];
        };
        let period = std::f64::consts::TAU / omega;
        let comes_back_after = |periods: usize| {
            let begin = Point { t: 0.0, y: elsewhere.start };
            let options = IntegrationOptions::with_tolerance(1e-10);
            let end = periods as f64 * period;
            let path = integrate_first_order(rates, begin, end, &[], &options).expect("a motion");
            let [x, v] = path.end().y;
            (x - elsewhere.start[0]).hypot(v - elsewhere.start[1]) < 1e-3 * elsewhere.peak
        };
        let periods = elsewhere.periods.expect("a motion that comes back");
        assert_eq!(elsewhere.drive_periods, Some(periods));
        assert!(comes_back_after(periods), "{elsewhere:?}");
        assert!(!(1..periods).any(comes_back_after), "{elsewhere:?}");
    }
}

/// Where the range begins between the folds, or ends there, all three motions are found: as many as
/// `s ((1 - Omega^2 + 3 k s/4)^2 + (c Omega)^2) = F^2` has roots. Neither rest nor a simulation
/// need lead to the resonant ones.
#[test]
fn a_narrow_range_has_every_motion_of_its_inside() {
    let equation = "x'' + c*x' + x + k*x^3 - F*cos(Omega*t) = 0";
    for (range, parameters) in [
        ([1.2, 1.3], vec![1.205, 1.25]),
        ([1.0, 1.2], vec![1.05, 1.1, 1.18]),
        ([1.19, 1.3], vec![1.195, 1.21, 1.22]),
        ([1.19, 1.2], vec![1.195]),
    ] {
        let found = respond(&ResponseRequest {
            harmonics: Some(1),
            ..question(equation, "Omega", range, "c = 1/10, k = 1/10, F = 3/10")
        })
        .expect("a response");
        for omega in parameters {
            let excess = |s: f64| {
                let stiffness = 1.0 - omega * omega + 0.075 * s;
                s * (stiffness * stiffness + (0.1 * omega).powi(2)) - 0.09
            };
            let places: Vec<f64> = (0..=20_000).map(|step| f64::from(step) * 1e-3).collect();
            let roots =
                places.windows(2).filter(|pair| excess(pair[0]) * excess(pair[1]) < 0.0).count();
            assert_eq!(passing(&found, omega).len(), roots, "{range:?} at {omega}");
        }
    }
}

#[test]
fn both_stable_motions_are_where_a_simulation_settles() {
    let found = duffing();
    assert_eq!((found.verdict, found.unjudged), (Verdict::Pass, 0));
    assert!(found.error.is_some_and(|error| error < 1e-5), "{:?}", found.error);
    for (parameter, expected) in [(0.7, 1), (1.5, 3), (2.2, 1)] {
        let motions = passing(&found, parameter);
        assert_eq!(motions.len(), expected, "{parameter}");
        for point in motions.iter().filter(|point| point.stable == Some(true)) {
            let numbers = [("c", 0.1), ("F", 0.3), ("Omega", point.parameter)];
            let period = std::f64::consts::TAU / point.parameter;
            // A tenth aside: it comes back.
            let start = [1.1 * point.start[0], 0.9 * point.start[1]];
            let (_, amplitude, peak) = simulated(DUFFING, &numbers, start, period, 80);
            assert!((point.amplitude / amplitude - 1.0).abs() < 1e-5, "{point:?}: {amplitude}");
            assert!((point.peak / peak - 1.0).abs() < 1e-4, "{point:?}: {peak}");
        }
        assert_eq!(
            motions.iter().filter(|point| point.stable == Some(false)).count(),
            expected / 2
        );
    }
}

#[test]
fn a_simulation_jumps_at_the_folds() {
    let found = duffing();
    let [upper, lower] = &places(&found, BifurcationKind::Fold)[..] else {
        panic!("{:?}", found.bifurcations)
    };
    let points = &found.branches[0].points;
    let near = |fold: &Bifurcation, high: bool| {
        let beside =
            |point: &&SteadyMotion| point.stable == Some(true) && (point.amplitude > 1.0) == high;
        let distance = |point: &SteadyMotion| (point.parameter - fold.parameter).abs();
        let of_part = points.iter().filter(beside);
        of_part
            .min_by(|one, other| distance(one).total_cmp(&distance(other)))
            .expect("a point")
            .clone()
    };
    // Up beyond the upper fold it falls, down beyond the lower one it rises; on this side it stays.
    for (fold, high, step) in [(upper, true, 1.0), (lower, false, -1.0)] {
        let point = near(fold, high);
        let after = |offset: f64| {
            let parameter = fold.parameter * (1.0 + 0.004 * offset * step);
            let numbers = [("c", 0.1), ("F", 0.3), ("Omega", parameter)];
            simulated(DUFFING, &numbers, point.start, std::f64::consts::TAU / parameter, 150).1
        };
        let (before, beyond) = (after(-1.0), after(1.0));
        assert_eq!(before > 1.0, high, "{fold:?}: {before}");
        assert_eq!(beyond > 1.0, !high, "{fold:?}: {beyond}");
    }
}

#[test]
fn a_symmetric_motion_has_no_even_harmonics_and_multipliers_obey_liouville() {
    let found = duffing();
    for point in &found.branches[0].points {
        let even = point.harmonics.iter().step_by(2);
        assert!(even.flatten().all(|value| value.abs() < 1e-11), "{point:?}");
        let [one, other] = point.multipliers.expect("multipliers");
        let decay = (-0.1 * std::f64::consts::TAU / point.parameter).exp();
        assert!(((one * other).re / decay - 1.0).abs() < 1e-6, "{point:?}");
    }
}

#[test]
fn beyond_a_period_doubling_a_simulation_takes_two_periods() {
    let wells = "x'' + x'/4 - x + x^3 - F*cos(Omega*t) = 0";
    let found = response(wells, "F", [0.05, 0.2], "Omega = 1");
    assert_eq!(found.verdict, Verdict::Pass);
    let mirrored: Vec<bool> = found.branches.iter().map(|branch| branch.mirrored).collect();
    assert_eq!(
        mirrored,
        [true, false, true],
        "one well stands for both, and between them is one motion"
    );
    let doublings = places(&found, BifurcationKind::PeriodDoubling);
    let [doubling] = &doublings[..] else { panic!("{doublings:?}") };
    let beside = |offset: f64| {
        let distance =
            |point: &SteadyMotion| (point.parameter - doubling.parameter * (1.0 + offset)).abs();
        let on = found.branches[doubling.branch].points.iter();
        let upper = on.filter(|point| point.amplitude > 0.5);
        upper
            .min_by(|one, other| distance(one).total_cmp(&distance(other)))
            .expect("a point")
            .clone()
    };
    let returns = |offset: f64| {
        let point = beside(offset);
        let force = doubling.parameter * (1.0 + offset);
        let numbers = [("F", force), ("Omega", 1.0)];
        let period = std::f64::consts::TAU;
        let start = [point.start[0] + 1e-3, point.start[1]];
        let (settled, ..) = simulated(wells, &numbers, start, period, 240);
        let after = |periods: u32| {
            let (state, ..) = simulated(wells, &numbers, settled, period, periods);
            (state[0] - settled[0]).hypot(state[1] - settled[1])
        };
        (after(1), after(2))
    };
    let before = returns(-0.02);
    assert!(before.0 < 1e-5, "{before:?}");
    let beyond = returns(0.02);
    assert!(beyond.0 > 1e-2 && beyond.1 < 1e-4, "{beyond:?}");
    // The doubled motions are a branch of their own, born there.
    let doubled =
        respond(&ResponseRequest { periods: 2, ..question(wells, "F", [0.15, 0.2], "Omega = 1") })
            .expect("a response");
    let born =
        doubled.bifurcations.iter().filter(|found| found.kind == BifurcationKind::BranchPoint);
    assert!(
        born.clone().any(|born| (born.parameter / doubling.parameter - 1.0).abs() < 1e-5),
        "{:?}",
        doubled.bifurcations
    );
    let lasting = |point: &&SteadyMotion| point.stable == Some(true) && point.amplitude > 0.02;
    assert!(doubled.branches.iter().flat_map(|branch| &branch.points).any(|point| lasting(&point)));
}

/// By Liouville's theorem the determinant of M is 1 where the mean of the damping is zero: the mean
/// of x^2 is 1 there.
#[test]
fn a_locked_oscillator_unlocks_where_its_mean_damping_vanishes() {
    let van_der_pol = "x'' - mu*(1 - x^2)*x' + x - F*cos(Omega*t) = 0";
    let found = response(van_der_pol, "Omega", [0.7, 1.4], "mu = 1/5, F = 1/2");
    let unlocked = places(&found, BifurcationKind::NeimarkSacker);
    assert_eq!(unlocked.len(), 2, "{:?}", found.bifurcations);
    for place in &unlocked {
        // Seen closely, so that a straight line between two points will do.
        let close = [0.998, 1.002].map(|factor| factor * place.parameter);
        let closely = response(van_der_pol, "Omega", close, "mu = 1/5, F = 1/2");
        let again = places(&closely, BifurcationKind::NeimarkSacker);
        assert!(
            again.len() == 1 && (again[0].parameter - place.parameter).abs() < 1e-6,
            "{again:?}"
        );
        let passes = |pair: &&[SteadyMotion]| {
            (pair[0].parameter - place.parameter) * (pair[1].parameter - place.parameter) <= 0.0
        };
        let pair = closely.branches[0].points.windows(2).find(passes).expect("two points");
        let mean_damping = |point: &SteadyMotion| {
            let squares = point.harmonics.iter().skip(1).flatten().map(|value| 0.5 * value * value);
            point.harmonics[0][0].powi(2) + squares.sum::<f64>() - 1.0
        };
        let [before, after] = [mean_damping(&pair[0]), mean_damping(&pair[1])];
        let part = (place.parameter - pair[0].parameter) / (pair[1].parameter - pair[0].parameter);
        let there = before + part * (after - before);
        assert!(before * after < 0.0 && there.abs() < 1e-5, "{before} {after}: {there}");
    }
    // Outside it never repeats itself.
    assert!(
        found
            .elsewhere
            .iter()
            .any(|elsewhere| elsewhere.periods.is_none() && elsewhere.parameter == 0.7)
    );
}

#[test]
fn a_contact_bends_the_resonance() {
    let stop = "x'' + x'/10 + x + k*(x - 1/2)^(3/2)*H(x - 1/2) - F*cos(Omega*t) = 0";
    let found = response(stop, "Omega", [0.7, 1.8], "k = 20, F = 1/10");
    assert_eq!(found.verdict, Verdict::Pass, "{:?} {}", found.error, found.unjudged);
    assert_eq!(places(&found, BifurcationKind::Fold).len(), 2, "{:?}", found.bifurcations);
    for parameter in [0.9, 1.15, 1.6] {
        for point in passing(&found, parameter).iter().filter(|point| point.stable == Some(true)) {
            let numbers = [("k", 20.0), ("F", 0.1), ("Omega", point.parameter)];
            let period = std::f64::consts::TAU / point.parameter;
            let start = [1.05 * point.start[0], point.start[1]];
            let (_, amplitude, peak) = simulated(stop, &numbers, start, period, 70);
            assert!((point.amplitude / amplitude - 1.0).abs() < 2e-3, "{point:?}: {amplitude}");
            assert!((point.peak / peak - 1.0).abs() < 2e-3, "{point:?}: {peak}");
        }
    }
}

/// Motions of a third of the frequency are a closed branch, or one that never touches that of the
/// main resonance.
#[test]
fn subharmonic_motions_are_found_apart() {
    let cubic = "x'' + x'/20 + x + x^3/10 - F*cos(Omega*t) = 0";
    let found =
        respond(&ResponseRequest { periods: 3, ..question(cubic, "Omega", [3.0, 6.0], "F = 30") })
            .expect("a response");
    let third =
        |point: &&SteadyMotion| point.amplitude > 0.2 * point.peak && point.stable == Some(true);
    let lasting: Vec<&SteadyMotion> =
        found.branches.iter().flat_map(|branch| &branch.points).filter(third).collect();
    assert!(lasting.len() > 10, "{}", lasting.len());
    let point = lasting[lasting.len() / 2];
    let numbers = [("F", 30.0), ("Omega", point.parameter)];
    let period = 3.0 * std::f64::consts::TAU / point.parameter;
    let start = [point.start[0] + 1e-2, point.start[1]];
    let (_, amplitude, peak) = simulated(cubic, &numbers, start, period, 120);
    assert!((point.amplitude / amplitude - 1.0).abs() < 1e-4, "{amplitude} {point:?}");
    assert!((point.peak / peak - 1.0).abs() < 1e-3);
}

#[test]
fn the_backbone_is_the_law_of_the_free_motion() {
    let found = duffing();
    let options = lindstedt::Options {
        order: Some(6),
        amplitude: Some(AmplitudeConvention::FirstHarmonic),
        ..lindstedt::Options::default()
    };
    let free = Oscillator::parse("x'' + x + eps*x^3 = 0").expect("an equation");
    let law = solve(&free, &options).expect("a law");
    let mut seen = 0;
    for point in found.backbone[0].iter().filter(|point| point.amplitude < 0.5) {
        let at = format!("eps = 1, a = {}", point.amplitude).parse().expect("values");
        let frequency = lindstedt::judge(&free, &law, &at, 0.01).expect("a verdict").frequency;
        let frequency = frequency.expect("a frequency");
        assert!((point.parameter / frequency - 1.0).abs() < 1e-5, "{point:?}: {frequency}");
        seen += 1;
    }
    assert!(seen > 20);
    // Resonance bends along it: the fold at the top is beside it.
    let fold = places(&found, BifurcationKind::Fold)[0];
    let on = found.backbone[0].iter().min_by(|one, other| {
        let distance = |amplitude: f64| (amplitude - fold.amplitude).abs();
        distance(one.amplitude).total_cmp(&distance(other.amplitude))
    });
    assert!((on.expect("a point").parameter / fold.parameter - 1.0).abs() < 0.01);
}

#[test]
fn without_damping_a_linear_resonance_is_unbounded() {
    let found = response("x'' + x - F*cos(Omega*t) = 0", "Omega", [0.6, 1.5], "F = 1/10");
    let unbounded = found
        .branches
        .iter()
        .flat_map(|branch| branch.ends)
        .filter(|end| *end == BranchEnd::Unbounded);
    assert_eq!((found.branches.len(), unbounded.count()), (2, 2));
    for point in found.branches.iter().flat_map(|branch| &branch.points) {
        let amplitude = 0.1 / (1.0 - point.parameter.powi(2)).abs();
        assert!((point.amplitude / amplitude - 1.0).abs() < 1e-6, "{point:?}");
    }
    // With its resonance in the middle, and where twice the frequency is that of the free motion;
    // nothing twice, nothing missing.
    for (range, drive) in [([0.5, 1.5], 0.1), ([0.4, 1.6], 0.1), ([0.5, 1.5], 0.3)] {
        let values = format!("F = {drive}");
        let found = response("x'' + x - F*cos(Omega*t) = 0", "Omega", range, &values);
        assert_eq!(found.branches.len(), 2, "{range:?}");
        let mut ends: Vec<f64> = Vec::new();
        for branch in &found.branches {
            for point in &branch.points {
                let amplitude = drive / (1.0 - point.parameter.powi(2)).abs();
                assert!((point.amplitude / amplitude - 1.0).abs() < 1e-6, "{point:?}");
            }
            ends.extend(
                [branch.points.first(), branch.points.last()]
                    .map(|point| point.expect("a point").parameter),
            );
        }
        ends.sort_by(f64::total_cmp);
        for (end, place) in ends.into_iter().zip([range[0], 1.0, 1.0, range[1]]) {
            assert!((end - place).abs() < 2e-4, "{range:?}: {end}");
        }
    }
    let refused = respond(&question("x'' + x - F*cos(Omega*t) = 0", "F", [0.1, 1.0], "Omega = 1"));
    let message = refused.expect_err("no motion").to_string();
    assert!(message.contains("unbounded at resonance"), "{message}");
}

#[test]
fn what_cannot_be_answered_is_refused_by_name() {
    for (equation, parameter, range, values, words) in [
        ("x'' + c*x' + x = 0", "c", [0.1, 1.0], "", "no drive"),
        ("x'' + c*x' + x - exp(-t) = 0", "c", [0.1, 1.0], "", "`-exp(-t)` is not periodic"),
        (DUFFING, "Omega", [0.5, 1.5], "c = 1/10", "no value for `F`"),
        (DUFFING, "omega", [0.5, 1.5], "c = 1/10, F = 1", "no parameter `omega`"),
        (DUFFING, "Omega", [0.5, 1.5], "c = 1/10, F = 1, q = 2", "a value for `q`"),
        (DUFFING, "Omega", [0.5, 1.5], "c = 1/10, F = 1, Omega = 2", "varies and is given"),
        (DUFFING, "Omega", [1.5, 0.5], "c = 1/10, F = 1", "must go from"),
        (DUFFING, "Omega", [0.5, f64::INFINITY], "c = 1/10, F = 1", "must go from"),
        (DUFFING, "Omega", [-0.5, 0.5], "c = 1/10, F = 1", "must be positive"),
        (
            "x'' + x'/9 + x - cos(t) - cos(Omega*t) = 0",
            "Omega",
            [0.5, 1.5],
            "",
            "no whole multiples",
        ),
    ] {
        let message =
            respond(&question(equation, parameter, range, values)).expect_err(equation).to_string();
        assert!(message.contains(words), "{equation}: {message}");
    }
    for (harmonics, periods) in [(Some(0), 1), (Some(65), 1), (None, 0), (None, 13)] {
        let refused = respond(&ResponseRequest {
            harmonics,
            periods,
            ..question(DUFFING, "Omega", [0.5, 1.5], "c = 1/10, F = 1")
        });
        assert!(refused.is_err(), "{harmonics:?} {periods}");
    }
}

/// The table of `docs/response.md` is what is computed: both folds and the largest error by the
/// number of harmonics.
#[test]
fn the_page_says_how_many_harmonics_are_enough() {
    let page = include_str!("../../docs/response.md");
    let mut rows = 0;
    for line in page.lines() {
        let cells: Vec<f64> = line.split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
        let [harmonics, down, up, error] = cells[..] else {
            continue;
        };
        let found = respond(&ResponseRequest {
            harmonics: Some(harmonics as usize),
            ..question(DUFFING, "Omega", [0.5, 2.0], "c = 1/10, F = 3/10")
        })
        .expect("a response");
        let folds: Vec<f64> = found.bifurcations.iter().map(|found| found.parameter).collect();
        assert!(
            folds.len() == 2 && (folds[0] - down).abs() < 6e-6 && (folds[1] - up).abs() < 6e-6,
            "{line}: {folds:?}"
        );
        let largest = found.error.expect("an error");
        assert!((0.5..2.0).contains(&(largest / error)), "{line}: {largest}");
        rows += 1;
    }
    assert_eq!(rows, 5);
}

/// The steady motions of multiple scales beside the branches: their error falls with everything
/// small, by the order that is kept.
#[test]
fn slow_equations_come_nearer_with_their_order() {
    let error = |order: u32, d: u32| {
        let equation = "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)";
        let values = format!("zeta = 1/{d}, eps = 1/{d}, F = 1/{d}");
        let width = 3.0 / f64::from(d);
        let question = ResponseRequest::new(equation, "Omega", [1.0 - width, 1.0 + width], &values)
            .expect("a question");
        let options = lindstedt::Options {
            method: Some(lindstedt::Method::MultipleScales),
            order: Some(order),
            resonance: Some((1, 1)),
            ..lindstedt::Options::default()
        };
        let solution =
            lindstedt::solve(question.equations.oscillator().expect("one coordinate"), &options)
                .expect("slow equations");
        let slow = respond(&question)
            .expect("a response")
            .with_slow_equations(solution)
            .slow
            .expect("states");
        assert_eq!(slow.missing, 0);
        assert!(slow.points > 20 && slow.states.len() > 240);
        slow.error.expect("an error")
    };
    for (order, least) in [(1, 0.7), (2, 1.6), (3, 2.5)] {
        let (large, small) = (error(order, 20), error(order, 40));
        let slope = (large / small).log2();
        assert!(slope > least, "order {order}: {large} and {small}, slope {slope}");
    }
}

/// The principal parametric resonance: the edges of the tongue by slow equations of first order,
/// `(Omega - 2)^2 = eps^2/4 - 4 zeta^2`, are a little aside of those of the branches, so that beside
/// them no amplitude is compared; the others are right.
#[test]
fn slow_equations_of_a_parametric_resonance_pass() {
    let equation = "x'' + 2*zeta*x' + (1 + eps*cos(Omega*t))*x + x^3 = 0";
    let asked = question(equation, "Omega", [1.9, 2.1], "zeta = 1/200, eps = 1/20");
    let asked = ResponseRequest { periods: 2, ..asked };
    let options = lindstedt::Options {
        method: Some(lindstedt::Method::MultipleScales),
        resonance: Some((2, 1)),
        ..lindstedt::Options::default()
    };
    let solution = solve(asked.equations.oscillator().expect("one coordinate"), &options)
        .expect("slow equations");
    let found = respond(&asked).expect("a response").with_slow_equations(solution);
    let edges = places(&found, BifurcationKind::BranchPoint);
    assert_eq!(edges.len(), 2, "{edges:?}");
    let half = (0.05_f64.powi(2) / 4.0 - 4.0 * 0.005_f64.powi(2)).sqrt();
    for edge in &edges {
        assert!(((edge.parameter - 2.0).abs() - half).abs() < 1e-3, "{edge:?}");
    }
    let slow = found.slow.expect("states");
    assert!(slow.beside > 20 && slow.points > 20 && slow.missing == 0, "{slow:?}");
    assert_eq!(slow.verdict, Verdict::Pass, "{:?}", slow.error);
}

/// What jumps with the velocity on no line of places and velocities is refused by name; what has no
/// jump is not, nor are several lines.
#[test]
fn forces_that_jump_on_no_line_are_refused() {
    let ask = |force: &str| {
        let equation = format!("x'' + x'/10 + x + {force} = F*cos(Omega*t)");
        respond(&question(&equation, "Omega", [1.4, 1.5], "F = 1/5"))
    };
    for force in ["H(x'^2 - 1)*x", "sgn(x' - cos(Omega*t))"] {
        let error = ask(force).expect_err(force).to_string();
        assert!(error.contains("jumps with the velocity"), "{force}: {error}");
    }
    let corner = ask("x'^2*sgn(x')/20").expect("a response");
    assert!(!corner.jumps && corner.unjudged == 0);
    assert!(corner.error.is_some_and(|error| error < 1e-5), "{:?}", corner.error);
    assert!(
        ask("(sgn(x') + sgn(x' - 1))/20").is_ok_and(|found| found.by_map && found.unjudged == 0)
    );
}

/// A pendulum that has gone over the top swings as before, a turn away: that is no other branch.
/// Without the turns there are two ways to swing below the jump, the small and the large, on
/// branches that do not meet above.
#[test]
fn a_turn_of_a_pendulum_away_is_the_same_branch() {
    let found =
        response("x'' + x'/10 + sin(x) - F*cos(Omega*t) = 0", "Omega", [0.5, 1.5], "F = 1/5");
    let starts: Vec<[f64; 2]> = found
        .branches
        .iter()
        .filter_map(|branch| branch.points.first())
        .map(|point| [point.parameter, point.peak])
        .collect();
    for (index, one) in starts.iter().enumerate() {
        let again = starts[..index]
            .iter()
            .any(|other| (one[0] - other[0]).abs() < 1e-9 && (one[1] - other[1]).abs() < 1e-4);
        assert!(!again, "{starts:?}");
    }
    assert!((2..=4).contains(&found.branches.len()), "{starts:?}");
}

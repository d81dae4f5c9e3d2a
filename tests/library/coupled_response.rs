//! Steady states of coupled equations, held to closed forms, to published cases with values computed
//! by other programs, and to motions integrated here.

use lindstedt::Verdict;
use lindstedt::numeric::ode::{IntegrationOptions, Point, integrate_first_order};
use lindstedt::response::bifurcation::BifurcationKind;
use lindstedt::response::continuation::BranchEnd;
use lindstedt::response::{
    AperiodicMotion, Criticality, Equations, EquilibriumChange, ResponseDiagram, ResponseRequest,
    SteadyMotion, respond,
};

fn question(equations: &str, parameter: &str, range: [f64; 2], values: &str) -> ResponseRequest {
    ResponseRequest::new(equations, parameter, range, values).expect(equations)
}

fn answer(equations: &str, parameter: &str, range: [f64; 2], values: &str) -> ResponseDiagram {
    let found = respond(&question(equations, parameter, range, values)).expect(equations);
    assert!(found.error.is_some_and(|error| error < 1e-4), "{equations}: {:?}", found.error);
    found
}

/// The values of the parameter at which bifurcations of a kind lie, in order.
fn places(found: &ResponseDiagram, kind: BifurcationKind) -> Vec<f64> {
    let all = found.bifurcations.iter().filter(|place| place.kind == kind);
    let mut all: Vec<f64> = all.map(|place| place.parameter).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// The motions at the upper end of the range, the smallest first.
fn at_end(found: &ResponseDiagram) -> Vec<&SteadyMotion> {
    let end = found.question.range[1];
    let ends =
        found.branches.iter().flat_map(|branch| [branch.points.first(), branch.points.last()]);
    let mut ends: Vec<&SteadyMotion> =
        ends.flatten().filter(|point| point.parameter == end).collect();
    ends.sort_by(|one, other| one.amplitude.total_cmp(&other.amplitude));
    ends
}

fn near(found: &[f64], expected: &[f64], within: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (one, other) in found.iter().zip(expected) {
        assert!((one - other).abs() < within, "{found:?} {expected:?}");
    }
}

/// A motion of two coordinates closes after its period, integrated here from its start.
fn closes(point: &SteadyMotion, periods: f64, rates: impl Fn(f64, &[f64; 4]) -> [f64; 4]) {
    let [x, y] = &point.coordinates[..] else { panic!("{point:?}") };
    let start = [x.start, y.start, x.rate, y.rate];
    let in_time = |t: f64, state: &[f64; 4], out: &mut [f64; 4]| *out = rates(t, state);
    let period = periods * std::f64::consts::TAU / point.frequency;
    let options = IntegrationOptions::with_tolerance(1e-12);
    let path = integrate_first_order(in_time, Point { t: 0.0, y: start }, period, &[], &options);
    let end = path.expect("a path").end().y;
    let apart = end.iter().zip(&start).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    let size = x.peak.max(y.peak).max(1e-3) * (1.0 + point.frequency);
    let grown = point.multipliers.map_or(1.0, |all| all[0].norm().max(1.0));
    assert!(apart < 1e-7 * size * grown, "{point:?} {apart}");
}

/// x'' + c x' + 2 x - y = cos(w t), y'' + c y' + 2 y - x = 0: by the modes x + y and x - y.
#[test]
fn a_linear_pair_has_its_closed_form() {
    let text = "x'' + c*x' + 2*x - y = cos(w*t); y'' + c*y' + 2*y - x = 0";
    let found = answer(text, "w", [0.5, 2.5], "c = 1/5");
    assert_eq!(found.branches.len(), 1);
    assert!(found.bifurcations.is_empty() && found.elsewhere.is_empty());
    for point in &found.branches[0].points {
        let w = point.parameter;
        let gain = |square: f64| num_complex::Complex::new(square - w * w, 0.2 * w).inv();
        let (sum, difference) = (gain(1.0), gain(3.0));
        let exact = [(sum + difference) / 2.0, (sum - difference) / 2.0];
        for (motion, exact) in point.coordinates.iter().zip(exact) {
            assert!((motion.amplitude - exact.norm()).abs() < 1e-9, "{point:?}");
            assert!((motion.peak - exact.norm()).abs() < 1e-7, "{point:?}");
            let turned = (motion.phase + exact.arg()).rem_euclid(std::f64::consts::TAU);
            assert!(turned.min(std::f64::consts::TAU - turned) < 1e-8, "{point:?}");
        }
        // Both modes decay alike; where their multipliers coincide an error of the map enters by its
        // square root.
        let expected = (-0.1 * std::f64::consts::TAU / w).exp();
        let largest = point.multipliers.expect("multipliers")[0].norm();
        assert!((largest / expected - 1.0).abs() < 1e-6 && point.stable == Some(true));
    }
}

/// Two masses with a cubic spring (M. Krack and J. Gross, *Harmonic Balance for Nonlinear Vibration
/// Problems*, Springer 2019, example 02 of NLvib), whose text names turning points and
/// Neimark-Sacker points; the values are by shooting in another program.
#[test]
fn two_masses_with_cubic_springs() {
    let text = "x'' + .002*x' + .013*(x' - y') + x + .0453*(x - y) + x^3 + .0042*(x - y)^3 = .11*cos(w*t); \
                .05*y'' + .013*(y' - x') + .0453*(y - x) + .0042*(y - x)^3 = 0";
    let found = answer(text, "w", [0.8, 1.4], "");
    near(&places(&found, BifurcationKind::NeimarkSacker), &[1.112_711_2, 1.195_736_7], 1e-6);
    near(&places(&found, BifurcationKind::Fold), &[1.206_219_5, 1.214_626_2], 1e-6);
    // Between the Neimark-Sacker points simulations do not come to rest.
    assert!(found.elsewhere.iter().all(|place| (1.112..1.196).contains(&place.parameter)));
    let found = answer(text, "w", [1.1, 1.21], "");
    let [small, middle, large] = at_end(&found)[..] else { panic!("{:?}", at_end(&found)) };
    for (point, expected, stable) in [
        (small, [0.367_659, 0.621_246], true),
        (middle, [0.507_826, 1.011_140], false),
        (large, [0.578_437, 1.395_937], true),
    ] {
        let amplitudes: Vec<f64> = point.coordinates.iter().map(|own| own.amplitude).collect();
        near(&amplitudes, &expected, 2e-6);
        assert_eq!(point.stable, Some(stable));
        closes(point, 1.0, |t, [x, y, v, u]| {
            let between = 0.013 * (v - u) + 0.0453 * (x - y) + 0.0042 * (x - y).powi(3);
            let first = 0.11 * (1.21 * t).cos() - 0.002 * v - between - x - x.powi(3);
            [*v, *u, first, between / 0.05]
        });
    }
}

/// The one-sided spring of NLvib, example 03: period doublings beside the largest amplitude, and a
/// Neimark-Sacker point below w = 0.635.
#[test]
fn a_one_sided_spring_doubles_the_period() {
    let text = "x'' + .03*(x' - y') + x - y + 100*max(x - 1, 0) = 0; y'' + .03*(2*y' - x') + 2*y - x = .1*cos(w*t)";
    let found = answer(text, "w", [0.6, 0.8], "");
    near(&places(&found, BifurcationKind::PeriodDoubling), &[0.738_783_0, 0.755_586_2], 2e-6);
    near(&places(&found, BifurcationKind::NeimarkSacker), &[0.618_606_9], 2e-6);
}

/// The pair of HarmonicBalance.jl with a limit cycle of its slow equations, which begins about F =
/// 0.010 on the lower branch.
#[test]
fn two_duffing_oscillators_lose_their_motion_to_a_torus() {
    let text = "x'' + 27.4e-6*x' + w^2*x + 3.867e-7*x^3 + 2*154.1e-6*w*(x - y) = F*cos(1.4507941*t); \
                y'' + 27.4e-6*y' + w^2*y + 3.867e-7*y^3 + 2*154.1e-6*w*(y - x) = -8*F*cos(1.4507941*t)/100";
    let found = answer(text, "F", [0.002, 0.032], "w = 1.4504859");
    near(&places(&found, BifurcationKind::NeimarkSacker), &[0.010_730_25, 0.026_836_16], 1e-7);
    near(&places(&found, BifurcationKind::Fold), &[0.004_790_92, 0.028_929_84], 1e-7);
}

/// The pair near 1:3 of HarmonicBalance.jl: three motions, two of them stable.
#[test]
fn a_pair_near_one_to_three() {
    let text = "x'' + x + 0.008*x' + 0.02*x^3 + 0.015*y*x^2 = 0.03*cos(w*t); \
                y'' + 3.05^2*y + 0.008*y' + 0.4*y^3 + 0.005*x^3 = 0";
    let found = answer(text, "w", [0.98, 1.05], "");
    let motions = at_end(&found);
    near(
        &motions.iter().map(|point| point.amplitude).collect::<Vec<_>>(),
        &[0.295_454, 2.496_319, 2.697_583],
        2e-6,
    );
    let stable: Vec<_> = motions.iter().map(|point| point.stable).collect();
    assert_eq!(stable, [Some(true), Some(false), Some(true)]);
    // The third harmonic of the other oscillator.
    let [a, b] = motions[2].coordinates[1].harmonics[3];
    assert!((a.hypot(b) - 0.040_595).abs() < 2e-6);
}

/// Two masses with dry friction on the smaller one, as tanh (NLvib, example 05): amplitudes of the driven
/// motion, and the nonlinear mode as the cycles that a negative damping lam of all masses keeps up, by
/// shooting in another program.
#[test]
fn dry_friction_by_tanh_has_its_response_and_its_mode() {
    let driven = "x''/50 + 40*(x - y) + 5*tanh(20*x') = 0; y'' + 40*(y - x) + 600*y = 8*cos(w*t)";
    let found = answer(driven, "w", [24.59, 24.6], "");
    let [point] = at_end(&found)[..] else { panic!("{:?}", at_end(&found)) };
    let amplitudes: Vec<f64> = point.coordinates.iter().map(|own| own.amplitude).collect();
    near(&amplitudes, &[0.254_396_36, 0.180_931_07], 1e-7);
    assert_eq!(point.stable, Some(true));
    let free = "x''/50 - lam*x'/50 + 40*(x - y) + 5*tanh(20*x') = 0; y'' - lam*y' + 40*(y - x) + 600*y = 0";
    let found = answer(free, "lam", [0.024, 5.0], "");
    let [branch] = &found.branches[..] else { panic!("{:?}", found.branches.len()) };
    let ends = [branch.points.first(), branch.points.last()].map(|point| point.expect("a point"));
    let [large, small] = match ends[0].parameter == 0.024 {
        true => ends,
        false => [ends[1], ends[0]],
    };
    assert!((large.frequency - 24.156_219_304_95).abs() < 1e-8, "{large:?}");
    assert!((large.coordinates[0].start.abs() - 21.052_317).abs() < 1e-5, "{large:?}");
    assert_eq!((large.stable, small.stable), (Some(false), Some(true)));
    // The smallest ones begin where the damping of tanh, 5/(1/20), is that of the rest.
    assert!((small.parameter - 0.024_997_5).abs() < 1e-5 && small.peak < 1e-3, "{small:?}");
}

/// The three-wave pump of HarmonicBalance.jl, which drives at twice the frequency a spring with square and cube: the
/// doublings, and both motions of two drive periods at w = 0.98, by shooting in another program.
#[test]
fn a_square_pumps_a_motion_of_two_drive_periods() {
    let text = "x'' + x'/1000 + x + 2*x^2 + x^3 = cos(2*w*t)/200";
    let request = question(text, "w", [0.98, 1.01], "");
    let once = respond(&request).expect(text);
    near(&places(&once, BifurcationKind::PeriodDoubling), &[0.998_398_294, 1.001_578_305], 1e-7);
    assert_eq!(criticalities(&once, BifurcationKind::PeriodDoubling), [SUB, SUPER]);
    let twice = respond(&ResponseRequest { periods: 2, ..request }).expect(text);
    let points = twice.branches.iter().flat_map(|branch| &branch.points);
    let motions = points.filter(|point| point.parameter == 0.98 && point.amplitude > 0.01);
    let mut motions: Vec<&SteadyMotion> = motions.collect();
    motions.sort_by(|one, other| one.amplitude.total_cmp(&other.amplitude));
    let amplitudes: Vec<f64> = motions.iter().map(|point| point.amplitude).collect();
    near(&amplitudes, &[0.118_736_575, 0.128_432_144], 2e-6);
    let sizes = motions.iter().map(|point| point.multipliers.expect("multipliers")[0].norm());
    near(&sizes.collect::<Vec<_>>(), &[1.070_594_74, 0.996_799_43], 2e-5);
}

/// Two coupled parametric oscillators (HarmonicBalance.jl): rest and eight motions at w = 1, of
/// which four are stable; each pair is one motion, shifted by a period of the drive.
#[test]
fn two_parametric_oscillators_have_all_their_motions() {
    let text = "x'' + (1 - l*cos(2*w*t))*x + x'/200 + x^3 - y/200 = 0; y'' + (1 - l*cos(2*w*t))*y + y'/200 + y^3 - x/200 = 0";
    let request = question(text, "w", [0.985, 1.0], "l = 3/100");
    let found = respond(&ResponseRequest { periods: 2, ..request }).expect("a response");
    let motions = at_end(&found);
    let stable: Vec<f64> = motions
        .iter()
        .filter(|point| point.stable == Some(true))
        .map(|point| point.amplitude)
        .collect();
    near(&stable, &[0.110_353, 0.159_778], 2e-6);
    assert_eq!(motions.iter().filter(|point| point.amplitude > 1e-6).count(), 4, "{motions:?}");
}

/// A. H. Nayfeh and D. T. Mook, *Nonlinear Oscillations*, 6.5: beyond F = 0.004 the driven mode is
/// saturated, and all that is added goes into the other.
#[test]
fn the_driven_mode_saturates() {
    let text = "u1'' + u1'/50 + u1 = 2*u1*u2/5; u2'' + u2'/50 + 4*u2 = 3*u1^2/10 + F*cos(2*t)";
    let request = question(text, "F", [0.002, 0.008], "");
    let found = respond(&ResponseRequest { periods: 2, ..request }).expect("a response");
    near(&places(&found, BifurcationKind::BranchPoint), &[0.004_000_087_5], 1e-8);
    let pitchfork = found.bifurcations.iter().find(|one| one.kind == BifurcationKind::BranchPoint);
    assert_eq!(pitchfork.expect("one").criticality, Some(Criticality::Supercritical));
    let stable: Vec<_> =
        at_end(&found).into_iter().filter(|point| point.stable == Some(true)).collect();
    let [point] = stable[..] else { panic!("{stable:?}") };
    assert!((point.amplitude - 0.163_284_4).abs() < 1e-6);
    // Two periods of the drive: the second harmonic of the motion.
    let [a, b] = point.coordinates[1].harmonics[2];
    assert!((a.hypot(b) - 0.100_017_2).abs() < 1e-6);
}

/// The cycles of Lur'e's system in BifurcationKit.jl, which asserts a period doubling at
/// 0.63031334 within 1e-4; 0.630302006 is that of another program to its last digit. Hopf points at
/// a = 1, where a^2 = 1 of z^3 + a z^2 + z + 1 = 0.
#[test]
fn cycles_of_first_order_equations_double_their_period() {
    let found = answer("x' = y; y' = z; z' = -a*z - y - x + x^2", "a", [0.6, 1.2], "");
    let doublings = places(&found, BifurcationKind::PeriodDoubling);
    assert!((doublings[doublings.len() - 1] - 0.630_302_006).abs() < 1e-7, "{doublings:?}");
    let hopf = found.equilibria.iter().flat_map(|branch| &branch.changes);
    let hopf: Vec<_> = hopf.filter(|change| change.kind == BifurcationKind::Hopf).collect();
    let [hopf] = hopf[..] else { panic!("{hopf:?}") };
    assert!((hopf.parameter - 1.0).abs() < 1e-9);
    assert_eq!(hopf.criticality, Some(Criticality::Supercritical));
    let at = |a: f64| answer("x' = y; y' = z; z' = -a*z - y - x + x^2", "a", [0.75, a], "");
    let found = at(0.8);
    let [point] = at_end(&found)[..] else { panic!() };
    assert!((std::f64::consts::TAU / point.frequency - 6.328_627_21).abs() < 1e-7);
    assert!((point.peak - 0.5 * (0.543_310_34 + 0.337_572_49)).abs() < 1e-7);
}

/// Equilibria of X' = r X - X^3 + Y/10, Y' = -Y + X/5: X = 0, and X^2 = r + 1/50.
#[test]
fn equilibria_cross_and_are_judged_by_their_eigenvalues() {
    let found = respond(&question("X' = r*X - X^3 + Y/10; Y' = -Y + X/5", "r", [-1.0, 1.0], ""));
    let found = found.expect("equilibria");
    assert!(found.branches.is_empty() && found.equilibria.len() == 2);
    for branch in &found.equilibria {
        for point in &branch.points {
            let (r, x) = (point.parameter, point.value);
            assert!(x.abs() < 1e-7 || (x * x - r - 0.02).abs() < 1e-9, "{point:?}");
            // Of [r - 3 X^2, 1/10; 1/5, -1].
            let (trace, determinant) = (r - 3.0 * x * x - 1.0, 3.0 * x * x - r - 0.02);
            let largest = 0.5 * (trace + (trace * trace - 4.0 * determinant).sqrt());
            assert!((point.growth.expect("a number") - largest).abs() < 1e-8, "{point:?}");
        }
    }
    let changes: Vec<_> = found.equilibria.iter().flat_map(|branch| &branch.changes).collect();
    let [crossing] = changes[..] else { panic!("{changes:?}") };
    assert_eq!(crossing.kind, BifurcationKind::BranchPoint);
    assert!((crossing.parameter + 0.02).abs() < 1e-7);
}

/// The branch y = x^2, r = x^2 - x crosses x = 0 at r = 0 aslant and folds at r = -1/4; beside it z = 0 has a pitchfork
/// at r = 0.37, where x = sqrt(r) is 0.6083 on one branch and 0 on another.
#[test]
fn branch_points_of_equilibria_are_exact_on_both_branches() {
    let crossings = |equations: &str| {
        let found = respond(&question(equations, "r", [-1.0, 1.0], "")).expect("equilibria");
        let changes: Vec<_> = found.equilibria.iter().flat_map(|one| one.changes.clone()).collect();
        let is_crossing = |change: &&EquilibriumChange| change.kind == BifurcationKind::BranchPoint;
        let crossings = changes.iter().filter(is_crossing);
        crossings.map(|change| [change.parameter, change.value]).collect::<Vec<_>>()
    };
    let aslant = crossings("x' = r*x - x^3 + y; y' = -y + x^2");
    assert_eq!(aslant.len(), 2, "{aslant:?}");
    assert!(aslant.iter().flatten().all(|value| value.abs() < 1e-9), "{aslant:?}");
    let beside = crossings("x' = r*x - x^3 + z^2; y' = -y + x; z' = (r - 0.37)*z - z^3");
    let is_one = |[parameter, value]: &[f64; 2]| {
        let places = [[0.0, 0.0], [0.37, 0.0], [0.37, 0.37_f64.sqrt()], [0.37, -0.37_f64.sqrt()]];
        places.iter().any(|[p, x]| (parameter - p).abs() < 1e-9 && (value - x).abs() < 1e-8)
    };
    assert!(beside.len() >= 4 && beside.iter().all(is_one), "{beside:?}");
}

/// A coordinate without damping that nothing moves keeps its energy: the motion is not stable, and a simulation is not
/// in chaos.
#[test]
fn a_coordinate_without_damping_is_neither_stable_nor_chaotic() {
    let text = "x'' + x'/10 + x = cos(w*t); y'' + y = 0";
    let found = respond(&question(text, "w", [1.2, 1.4], "")).expect(text);
    assert!(
        found
            .branches
            .iter()
            .flat_map(|branch| &branch.points)
            .all(|point| point.stable == Some(false))
    );
    for place in &found.elsewhere {
        let chaotic = matches!(place.aperiodic, Some(AperiodicMotion::Chaotic(_)));
        assert!(!chaotic, "{place:?}");
    }
}

/// Two van der Pol oscillators locked to each other until w = 1.0500 (D. G. Aronson, G. B. Ermentrout
/// and N. Kopell, *Physica D* 41 (1990) 403, for the system).
#[test]
fn locked_cycles_end_in_a_fold() {
    let text =
        "x'' - (1 - x^2)*x'/10 + x = (y' - x')/20; y'' - (1 - y^2)*y'/10 + w^2*y = (x' - y')/20";
    let found = answer(text, "w", [1.0, 1.1], "");
    let fold = *places(&found, BifurcationKind::Fold).last().expect("a fold");
    assert!((fold - 1.050_02).abs() < 1e-5, "{fold}");
    let found = answer(text, "w", [1.0, 1.03], "");
    let stable: Vec<_> =
        at_end(&found).into_iter().filter(|point| point.stable == Some(true)).collect();
    let [point] = stable[..] else { panic!("{stable:?}") };
    assert!((std::f64::consts::TAU / point.frequency - 6.192_688_90).abs() < 1e-7);
    closes(point, 1.0, |_, [x, y, v, u]| {
        let of = |x: f64, v: f64| 0.1 * (1.0 - x * x) * v;
        let first = of(*x, *v) - x + 0.05 * (u - v);
        [*v, *u, first, of(*y, *u) - 1.03 * 1.03 * y + 0.05 * (v - u)]
    });
}

/// The modes of G. Kerschen and others, *Mech. Syst. Signal Process.* 23 (2009) 170, at w = 1.1, by
/// shooting in another program, and where the first one loses its stability.
#[test]
fn nonlinear_normal_modes_by_their_frequency() {
    let text = "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0";
    let found = answer(text, "omega", [0.95, 1.1], "");
    let [point] = at_end(&found)[..] else { panic!() };
    let starts: Vec<f64> = point.coordinates.iter().map(|own| own.start.abs()).collect();
    near(&starts, &[1.137_497_60, 1.408_884_01], 1e-7);
    closes(point, 1.0, |_, [x, y, v, u]| [*v, *u, y - 2.0 * x - 0.5 * x.powi(3), x - 2.0 * y]);
    let found = answer(text, "omega", [1.2, 1.29], "");
    near(&places(&found, BifurcationKind::BranchPoint), &[1.281_534_29], 1e-7);
    // The frequency of a linear mode does not change.
    let refused = respond(&question("x'' + x = y; y'' + y = x/2", "omega", [0.1, 1.0], ""));
    assert!(refused.expect_err("linear").to_string().contains("the linear modes have"));
    // The other mode begins at the square root of 3.
    let found = answer(text, "omega", [1.74, 2.0], "");
    let [point] = at_end(&found)[..] else { panic!() };
    let starts: Vec<f64> = point.coordinates.iter().map(|own| own.start.abs()).collect();
    near(&starts, &[2.015_806_37, 0.992_838_60], 1e-7);
}

/// A. F. Vakakis and R. H. Rand, *Int. J. Non-Linear Mech.* 27 (1992) 861: two equal oscillators whose coupling
/// vanishes with the amplitude. With y = c x both equations are x'' + x + (1 + K (1 - c)^3) x^3 = 0 if (1 - c^2) (K (1 - c)^2 + c) =
/// 0: the modes in phase and out of phase, and for K < 1/4 two localised ones, with which the other
/// loses its stability.
#[test]
fn equal_oscillators_have_their_localised_modes() {
    let text = "x'' + x + x^3 + K*(x - y)^3 = 0; y'' + y + y^3 + K*(y - x)^3 = 0";
    for (coupling, stable) in [(0.2_f64, false), (0.3, true)] {
        let found = answer(text, "omega", [1.0, 1.2], &format!("K = {coupling}"));
        let motions = at_end(&found);
        let mut shapes = vec![1.0, -1.0];
        let root = 1.0 - 4.0 * coupling;
        if root > 0.0 {
            let signs = [-1.0, 1.0];
            shapes.extend(
                signs.map(|sign| (2.0 * coupling - 1.0 + sign * root.sqrt()) / (2.0 * coupling)),
            );
        }
        assert_eq!(motions.len(), shapes.len(), "{motions:?}");
        let starts = |point: &SteadyMotion| [0, 1].map(|i| point.coordinates[i].start);
        let in_phase = motions.iter().map(|point| starts(point)).find(|[x, y]| x * y > 0.0);
        let amplitude = in_phase.expect("a mode in phase")[0];
        for c in shapes {
            let size = 1.0 + coupling * (1.0 - c).powi(3);
            let is_mode = |point: &&&SteadyMotion| {
                let [x, y] = starts(point);
                (y / x - c).abs() < 1e-6
                    && (x * x * size / (amplitude * amplitude) - 1.0).abs() < 1e-6
            };
            let mode = motions.iter().find(is_mode);
            let mode = mode.unwrap_or_else(|| panic!("{c}: {motions:?}"));
            closes(mode, 1.0, |_, [x, y, v, u]| {
                let between = coupling * (x - y).powi(3);
                [*v, *u, -x - x.powi(3) - between, -y - y.powi(3) + between]
            });
            if c == -1.0 {
                assert_eq!(mode.stable, Some(stable), "{mode:?}");
            }
        }
    }
}

/// The folds of Duffing's equation along the amplitude of the drive are those of its responses at
/// single amplitudes.
#[test]
fn folds_in_two_parameters_are_those_at_each_value() {
    let text = "x'' + x'/10 + x + x^3 = F*cos(Omega*t)";
    let request = question(text, "Omega", [0.5, 2.5], "F = 3/10");
    let request = ResponseRequest { along: Some(("F".into(), [0.1, 0.5])), ..request };
    let found = respond(&request).expect("curves");
    // The two folds meet in a cusp at a smaller force.
    assert_eq!(found.curves.len(), 2);
    for force in [0.2, 0.4] {
        let at = answer(text, "Omega", [0.5, 2.5], &format!("F = {force}"));
        for fold in places(&at, BifurcationKind::Fold) {
            let crossing = |pair: &[lindstedt::response::BifurcationCurvePoint]| {
                let (one, other) = (pair[0], pair[1]);
                let part = (force - one.along) / (other.along - one.along);
                let there = one.parameter + part * (other.parameter - one.parameter);
                (0.0..=1.0).contains(&part) && (there - fold).abs() < 2e-3
            };
            let mut pairs = found.curves.iter().flat_map(|curve| curve.points.windows(2));
            assert!(pairs.any(crossing), "{force} {fold}");
        }
    }
    let counted = found.stable_motions.expect("counts");
    let row = counted.along.iter().position(|force| (force - 0.3).abs() < 1e-9).expect("a row");
    for (omega, count) in counted.parameters.iter().zip(&counted.counts[row]) {
        let expected = if (1.324_236..1.779_72).contains(omega) { 2 } else { 1 };
        assert_eq!(*count, expected, "{omega}");
    }
}

/// A drive with which a period holds a hundred swings: the search ends, and says that it did.
#[test]
fn a_search_without_an_end_is_bounded() {
    let text = "x'' + x'/10 + x + x^3 - y/5 = 1000000*cos(Omega*t); y'' + y'/10 + 2*y - x/5 = 0";
    let found = respond(&question(text, "Omega", [0.5, 2.5], "")).expect(text);
    assert!(found.exhausted && found.is_full() && !found.branches.is_empty());
    assert_eq!(found.verdict, lindstedt::verify::Verdict::Fail);
}

/// A pendulum on a cart by its energies and by its equations.
#[test]
fn a_mechanism_has_the_response_of_its_equations() {
    let mechanism = lindstedt::mechanics::Mechanism::parse(
        &["s", "x"],
        "2*s'^2/2 + ((s' + x'*cos(x))^2 + (x'*sin(x))^2)/2",
        "-cos(x) + s^2",
    )
    .expect("a mechanism");
    let mechanism = lindstedt::mechanics::Mechanism {
        forces: [("s", "cos(w*t)/20 - s'/10"), ("x", "-x'/10")]
            .map(|(name, force)| (name.into(), force.parse().expect(force)))
            .into(),
        ..mechanism
    };
    let equations = mechanism.equations().expect("equations");
    let equations =
        lindstedt::coupled::CoupledEquations::of_mechanism(&equations).expect("coupled");
    let text = "3*s'' + x''*cos(x) - x'^2*sin(x) + 2*s + s'/10 = cos(w*t)/20; \
                x'' + s''*cos(x) + sin(x) + x'/10 = 0";
    // Both have the motions of the whole range in common; some of it tells.
    let request = question(text, "w", [0.8, 0.9], "");
    let by_text = respond(&request).expect("a response");
    let request = ResponseRequest { equations: Equations::Coupled(equations), ..request };
    let by_energies = respond(&request).expect("a response");
    let ends = [&by_text, &by_energies].map(|found| at_end(found)[0].clone());
    let [one, other] = ends;
    for (one, other) in one.coordinates.iter().zip(&other.coordinates) {
        assert!((one.amplitude - other.amplitude).abs() < 1e-9, "{one:?} {other:?}");
    }
}

#[test]
fn what_is_asked_wrongly_says_why() {
    for (equations, parameter, values, words) in [
        (
            "x'' + x'/5 + x = cos(w*t) + y; y'' + y'/5 + y = cos(pi*w*t)",
            "w",
            "",
            "no whole multiples",
        ),
        ("x'' + x - y = w*t; y'' + y'/5 + y = 0", "w", "", "not periodic in time"),
        ("x'' + k*x - y = 0; y'' + y - x = 0", "k", "", "a frequency for each energy"),
        ("x'' + x'/5 + k*x = y + cos(w*t); y'' + y'/5 + y = x", "w", "", "no value for `k`"),
        ("x'' + x'/5 + x = y + cos(w*t); y'' + y'/5 + y = x", "w", "q = 1", "`q`"),
        ("x'' + sgn(x')*sgn(y') + x = y + cos(w*t); y'' + sgn(y')/5 + y = x", "w", "", "jumps"),
    ] {
        let refused = respond(&question(equations, parameter, [0.5, 1.5], values));
        let message = refused.expect_err(equations).to_string();
        assert!(message.contains(words), "{equations}: {message}");
    }
}

/// The criticalities of bifurcations of a kind, in the order of the parameter.
fn criticalities(found: &ResponseDiagram, kind: BifurcationKind) -> Vec<Option<Criticality>> {
    let mut all: Vec<_> = found.bifurcations.iter().filter(|place| place.kind == kind).collect();
    all.sort_by(|one, other| one.parameter.total_cmp(&other.parameter));
    all.iter().map(|place| place.criticality).collect()
}

const SUPER: Option<Criticality> = Some(Criticality::Supercritical);
const SUB: Option<Criticality> = Some(Criticality::Subcritical);

/// A self-excited oscillator beside a driven one, and beside another that goes round its cycle: y = 0
/// loses its stability at mu = 0. With the damping -(mu - y^2) small motions of y grow to the amplitude
/// 2 sqrt(mu); with -(mu + y^2 - y^4) they have it for mu < 0, and are unstable.
#[test]
fn a_torus_is_born_stable_or_unstable() {
    let drive = |w: &str| format!("x'' + x'/5 + x = cos({w}*t) + x*y/10");
    let cycle = "x'' - (1 - x^2)*x'/10 + x = 0";
    for (other, square, expected) in [
        (drive("1.3"), 1, SUPER),
        (drive("1.3"), -1, SUB),
        (cycle.to_owned(), 1, SUPER),
        (cycle.to_owned(), -1, SUB),
        // The multipliers of y are the third roots of one.
        (drive("3"), 1, Some(Criticality::StronglyResonant)),
    ] {
        let damping = if square == 1 { "mu - y^2" } else { "mu + y^2 - y^4" };
        let text = format!("{other}; y'' - ({damping})*y' + y = x*y/10");
        let text = if expected == Some(Criticality::StronglyResonant) {
            text.replace("= x*y/10", "= 0")
        } else if other == cycle {
            text.replace("+ y =", "+ 2*y =")
        } else {
            text
        };
        let found = respond(&question(&text, "mu", [-0.1, 0.1], "")).expect(&text);
        near(&places(&found, BifurcationKind::NeimarkSacker), &[0.0], 1e-6);
        assert_eq!(criticalities(&found, BifurcationKind::NeimarkSacker), [expected], "{text}");
    }
}

/// Beside the Neimark-Sacker points of two masses with cubic springs, integrated here: the square of
/// the distance of a torus from the motion that repeats itself grows with that from the point.
#[test]
fn a_small_torus_surrounds_a_supercritical_point() {
    let text = "x'' + .002*x' + .013*(x' - y') + x + .0453*(x - y) + x^3 + .0042*(x - y)^3 = .11*cos(w*t); \
                .05*y'' + .013*(y' - x') + .0453*(y - x) + .0042*(y - x)^3 = 0";
    let found = answer(text, "w", [1.1, 1.2], "");
    assert_eq!(criticalities(&found, BifurcationKind::NeimarkSacker), [SUPER; 2]);
    let spread = |w: f64| {
        let at = answer(text, "w", [1.1, w], "");
        let [point] = at_end(&at)[..] else { panic!("{:?}", at_end(&at)) };
        let [x, y] = &point.coordinates[..] else { panic!() };
        let centre = [x.start, y.start, x.rate, y.rate];
        let mut state = centre.map(|value| value + 0.05);
        let options = IntegrationOptions::with_tolerance(1e-9);
        let mut farthest = 0.0_f64;
        for period in 0..1500 {
            let rates = |t: f64, [x, y, v, u]: &[f64; 4], out: &mut [f64; 4]| {
                let between = 0.013 * (v - u) + 0.0453 * (x - y) + 0.0042 * (x - y).powi(3);
                let first = 0.11 * (w * t).cos() - 0.002 * v - between - x - x.powi(3);
                *out = [*v, *u, first, between / 0.05];
            };
            let begin = Point { t: 0.0, y: state };
            let duration = std::f64::consts::TAU / w;
            let path = integrate_first_order(rates, begin, duration, &[], &options);
            state = path.expect("a path").end().y;
            let apart = state.iter().zip(&centre).map(|(one, other)| (one - other).abs());
            if period >= 1400 {
                farthest = farthest.max(apart.fold(0.0, f64::max));
            }
        }
        farthest
    };
    let [near, far] = [1.112_711 + 0.002, 1.112_711 + 0.004].map(spread);
    assert!(near < 0.4 && (1.3..1.6).contains(&(far / near)), "{near} {far}");
}

/// Cycles of O. E. Roessler's equations, whose first period doubling leads on to chaos (*Phys. Lett.*
/// 57A (1976) 397), and pitchforks of a cycle in closed form: z = 0 and z^2 = mu, or -mu nearly.
#[test]
fn cycles_branch_off_cycles() {
    let roessler = "x' = -y - z; y' = x + y/5; z' = 1/5 + z*(x - c)";
    let found = answer(roessler, "c", [2.0, 3.5], "");
    near(&places(&found, BifurcationKind::PeriodDoubling), &[2.832_445], 1e-5);
    assert_eq!(criticalities(&found, BifurcationKind::PeriodDoubling), [SUPER]);
    // The doubled cycle is found by simulations, and once.
    assert_eq!(found.branches.len(), 2);
    for (force, expected) in [("mu*z - z^3", SUPER), ("mu*z + z^3 - z^5", SUB)] {
        let text = format!("x'' - (1 - x^2)*x'/10 + x = 0; z' = {force}");
        let found = answer(&text, "mu", [-0.1, 0.1], "");
        near(&places(&found, BifurcationKind::BranchPoint), &[0.0], 1e-6);
        assert_eq!(criticalities(&found, BifurcationKind::BranchPoint), [expected]);
    }
    let lure = answer("x' = y; y' = z; z' = -a*z - y - x + x^2", "a", [0.6, 1.2], "");
    assert_eq!(criticalities(&lure, BifurcationKind::PeriodDoubling), [SUPER]);
}

/// Of one coordinate. Motions that grow out of rest in a parametric resonance have larger frequencies if
/// the spring hardens, smaller ones if it softens: they stand over the unstable frequencies at one edge,
/// and beyond them at the other.
#[test]
fn bifurcations_of_one_coordinate_are_sub_or_supercritical() {
    for (cubic, expected) in [("+ x^3", [SUPER, SUB]), ("- x^3/5", [SUB, SUPER])] {
        let text = format!("x'' + x'/100 + (1 - cos(2*w*t)/10)*x {cubic} = 0");
        let request = question(&text, "w", [0.9, 1.1], "");
        let once = respond(&request).expect(&text);
        assert_eq!(criticalities(&once, BifurcationKind::PeriodDoubling), expected);
        let twice = respond(&ResponseRequest { periods: 2, ..request }).expect(&text);
        assert_eq!(criticalities(&twice, BifurcationKind::BranchPoint), expected);
    }
    for (damping, expected) in [("mu - x^2", SUPER), ("mu + x^2 - x^4", SUB)] {
        let text = format!("x'' - ({damping})*x' + x = 0");
        let found = respond(&question(&text, "mu", [-0.5, 0.5], "")).expect(&text);
        assert_eq!(criticalities(&found, BifurcationKind::Hopf), [expected]);
    }
    // The drift of a driven van der Pol oscillator begins at small motions about the locked one (J.
    // Guckenheimer and P. Holmes, *Nonlinear Oscillations, Dynamical Systems, and Bifurcations of
    // Vector Fields*, Springer 1983, section 2.1).
    let text = "x'' - (1 - x^2)*x'/5 + x = F*cos(6*t/5)";
    let found = respond(&question(text, "F", [0.1, 2.0], "")).expect(text);
    assert_eq!(criticalities(&found, BifurcationKind::NeimarkSacker), [SUPER]);
}

/// Forces with corners that the motion crosses: the map beside it is smooth, and its cubic term tells that the
/// drift of a self-excited oscillator begins at small motions about the locked one. Integrated here, the
/// square of their size grows with the distance from the point.
#[test]
fn a_torus_across_corners_is_supercritical() {
    let text = "x'' - (1 - abs(x))*x'/5 + x = F*cos(6*t/5)";
    let found = answer(text, "F", [0.1, 2.0], "");
    let points = places(&found, BifurcationKind::NeimarkSacker);
    assert_eq!(criticalities(&found, BifurcationKind::NeimarkSacker), [SUPER], "{points:?}");
    let spread = |force: f64| {
        let rates = |t: f64, [x, v]: &[f64; 2], out: &mut [f64; 2]| {
            *out = [*v, force * (1.2 * t).cos() + (1.0 - x.abs()) * v / 5.0 - x];
        };
        let period = std::f64::consts::TAU / 1.2;
        let mut state = [0.5, 0.0];
        let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for count in 0..3000 {
            let options = IntegrationOptions::with_tolerance(1e-9);
            let begin = Point { t: 0.0, y: state };
            let path = integrate_first_order(rates, begin, period, &[], &options);
            state = path.expect("a path").end().y;
            if count >= 2600 {
                bounds[0] = [0, 1].map(|i| bounds[0][i].min(state[i]));
                bounds[1] = [0, 1].map(|i| bounds[1][i].max(state[i]));
            }
        }
        (bounds[1][0] - bounds[0][0]).max(bounds[1][1] - bounds[0][1])
    };
    let [beyond, near, far] = [0.01, -0.01, -0.02].map(|apart| spread(points[0] + apart));
    assert!(beyond < 1e-4 && (1.25..1.6).contains(&(far / near)), "{beyond} {near} {far}");
}

/// A motion that stands on a corner of the force has no cubic term, and nothing is said: the size of the
/// torus grows with the distance from the point here, and not with its root.
#[test]
fn nothing_is_said_of_a_torus_on_a_corner() {
    let text = "x'' + x'/5 + x = cos(1.3*t) + x*y/10; y'' - (mu - abs(y))*y' + y = x*y/10";
    let found = answer(text, "mu", [-0.1, 0.1], "");
    near(&places(&found, BifurcationKind::NeimarkSacker), &[0.0], 1e-4);
    assert_eq!(criticalities(&found, BifurcationKind::NeimarkSacker), [None]);
}

/// Of the equations of E. N. Lorenz (*J. Atmos. Sci.* 20 (1963) 130) with s = 10, b = 8/3: a pitchfork at r = 1, Hopf
/// points at s (s + b + 3)/(s - b - 1) = 470/19, and subcritical cycles from there down to the homoclinic orbit of the
/// origin at r = 13.9266 (C. Sparrow, *The Lorenz Equations*, Springer 1982), beside which the branch ends.
#[test]
fn lorenz_cycles_end_beside_the_homoclinic_orbit() {
    let text = "x' = 10*(y - x); y' = x*(r - z) - y; z' = x*y - 8*z/3";
    let found = respond(&question(text, "r", [0.5, 26.0], "")).expect("branches");
    let [zero, others] = &found.equilibria[..] else { panic!("{:?}", found.equilibria) };
    assert!(zero.points.iter().all(|point| point.value == 0.0));
    for point in &others.points {
        let square = 8.0 / 3.0 * (point.parameter - 1.0);
        assert!((point.value * point.value - square).abs() < 1e-7, "{point:?}");
    }
    let at_hopf = |change: &&EquilibriumChange| change.kind == BifurcationKind::Hopf;
    let hopf: Vec<_> = others.changes.iter().filter(at_hopf).collect();
    assert!(
        hopf.len() == 2 && hopf.iter().all(|hopf| (hopf.parameter - 470.0 / 19.0).abs() < 1e-8)
    );
    assert!(hopf.iter().all(|hopf| hopf.criticality == Some(Criticality::Subcritical)));
    let from_hopf = found.branches.iter().find(|branch| {
        branch.points.iter().any(|point| (point.parameter - 470.0 / 19.0).abs() < 1e-3)
    });
    let from_hopf = from_hopf.expect("cycles");
    let last = from_hopf.points.iter().map(|point| point.parameter).fold(f64::MAX, f64::min);
    assert!((13.9266..13.95).contains(&last), "{last}");
    assert!(found.bifurcations.is_empty(), "{:?}", found.bifurcations);
    assert!(from_hopf.ends.contains(&BranchEnd::Sensitive), "{:?}", from_hopf.ends);
    assert!(found.branches.iter().all(|branch| !branch.ends.contains(&BranchEnd::Lost)));
    assert_eq!(found.verdict, Verdict::Pass);
}

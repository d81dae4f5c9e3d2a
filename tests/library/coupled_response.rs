//! Steady states of coupled equations, held to closed forms, to published cases with values computed
//! by other programs, and to motions integrated here.

use lindstedt::numeric::ode::{IntegrationOptions, Point, integrate_first_order};
use lindstedt::response::bifurcation::BifurcationKind;
use lindstedt::response::{
    Criticality, Equations, ResponseDiagram, ResponseRequest, SteadyMotion, respond,
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
    let request = question(text, "w", [0.5, 0.9], "");
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
        ("x'' + sgn(x')/5 + x = y + cos(w*t); y'' + y'/5 + y = x", "w", "", "jumps"),
    ] {
        let refused = respond(&question(equations, parameter, [0.5, 1.5], values));
        let message = refused.expect_err(equations).to_string();
        assert!(message.contains(words), "{equations}: {message}");
    }
}

/// Every stable motion to which simulations of random pairs come is listed.
#[test]
fn simulations_of_random_pairs_come_to_listed_motions() {
    let number = |seed: usize, index: usize| {
        let root = [2.0_f64, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0][index % 7].sqrt();
        ((seed + 1) as f64 * root * (1.0 + (index / 7) as f64)).fract()
    };
    for seed in 0..4 {
        let own = |index: usize, low: f64, high: f64| {
            ((low + (high - low) * number(seed, index)) * 1e3).round() / 1e3
        };
        let (k, c, d) = (own(0, 0.5, 3.0), own(1, 0.05, 0.3), own(2, 0.05, 0.3));
        let (a, b, g, f) =
            (own(3, 0.0, 1.5), own(4, -0.3, 1.0), own(5, -0.5, 0.5), own(6, 0.1, 1.0));
        let text = format!(
            "x'' + {c}*x' + x + {a}*x^3 - ({g})*y = {f}*cos(w*t); y'' + {d}*y' + {k}*y + ({b})*x^2 + y^3/2 - ({g})*x = 0"
        );
        let w = 0.6 + 1.6 * number(seed, 7);
        let found = respond(&question(&text, "w", [0.5, w], "")).expect(&text);
        let motions = at_end(&found);
        let rates = |t: f64, [x, y, v, u]: &[f64; 4]| {
            let first = f * (w * t).cos() - c * v - x - a * x.powi(3) + g * y;
            [*v, *u, first, -d * u - k * y - b * x * x - 0.5 * y.powi(3) + g * x]
        };
        for start in 0..6 {
            let place = |index: usize| 6.0 * number(100 * seed + start, index) - 3.0;
            let mut state = [place(0), place(1), place(2), place(3)];
            let period = std::f64::consts::TAU / w;
            let options = IntegrationOptions::with_tolerance(1e-9);
            let mut last = state;
            for _ in 0..120 {
                let in_time = |t: f64, y: &[f64; 4], out: &mut [f64; 4]| *out = rates(t, y);
                let begin = Point { t: 0.0, y: state };
                let path = integrate_first_order(in_time, begin, period, &[], &options);
                (last, state) = (state, path.expect("a path").end().y);
            }
            let apart = |other: &[f64; 4]| {
                let each = state.iter().zip(other).map(|(one, other)| (one - other).abs());
                each.fold(0.0, f64::max)
            };
            if apart(&last) > 1e-5 {
                continue;
            }
            let is_listed = motions.iter().any(|point| {
                let [x, y] = &point.coordinates[..] else { panic!() };
                apart(&[x.start, y.start, x.rate, y.rate]) < 1e-2
            });
            assert!(is_listed, "{text} w = {w} {state:?} {motions:?}");
        }
    }
}

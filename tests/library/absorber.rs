//! Absorbers, held to published numbers, to the response of their equations of motion, and to motions
//! followed here.
//!
//! - J. P. Den Hartog, *Mechanical Vibrations*, section 3.3; O. Nishihara, T. Asami, *J. Vib. Acoust.* 124
//!   (2002) 576; T. Asami, O. Nishihara, A. M. Baz, *J. Vib. Acoust.* 124 (2002) 284.
//! - T. Li, S. Seguy, A. Berlioz, *Nonlinear Dyn.* 87 (2017) 2415.

use std::f64::consts::PI;

use lindstedt::absorber::{AbsorberError, AbsorberKind, AbsorberLaws, Excitation, derive};
use lindstedt::absorber_verdict::{JudgedAbsorber, judge_absorber};
use lindstedt::numeric::ode::root::find_root;
use lindstedt::numeric::ode::{IntegrationOptions, Point, integrate_first_order};
use lindstedt::response::bifurcation::BifurcationKind;
use lindstedt::response::{ResponseRequest, respond};
use lindstedt::{Values, Verdict};
use nalgebra::{Matrix4, Vector4};
use num_complex::Complex64;

const TUNED: AbsorberKind = AbsorberKind::Tuned(Excitation::Force);
const SHAKEN: AbsorberKind = AbsorberKind::Tuned(Excitation::Ground);

fn laws(kind: AbsorberKind) -> AbsorberLaws {
    derive(kind).expect("closed forms")
}

fn values(text: &str) -> Values {
    text.parse().expect(text)
}

fn judged(kind: AbsorberKind, at: &str) -> JudgedAbsorber {
    judge_absorber(&laws(kind), &values(at), 0.01).expect(at)
}

/// The value of a formula.
fn value(kind: AbsorberKind, at: &str, design: &str, name: &str) -> f64 {
    laws(kind).named_value(design, name, &values(at)).expect(name)
}

/// The truth of a formula.
fn truth(judged: &JudgedAbsorber, design: &str, name: &str) -> f64 {
    let own = judged.formulas.iter().find(|own| (own.design, own.name) == (design, name));
    own.and_then(|own| own.truth).expect(name)
}

#[test]
fn published_numbers() {
    for (design, name, published) in [
        ("equal-peaks", "tuning", 1.0 / 1.05),
        ("equal-peaks", "height", 6.403124237),
        ("lowest-peak", "tuning", 0.9523720443),
        ("lowest-variance", "tuning", 0.9642122253),
    ] {
        let own = value(TUNED, "mu = 0.05", design, name);
        assert!((own - published).abs() < 1e-9, "{design} {name}: {own}");
    }
    let least =
        value(AbsorberKind::ImpactSink, "r = 0.65, b = 1, mu = 0.01", "threshold", "amplitude");
    assert!((least - 0.1338258497).abs() < 1e-9, "{least}");
}

/// The formulas are exact, whatever the mass ratio: searches find the same numbers.
#[test]
fn searches_find_the_designs() {
    for (kind, at) in [
        (TUNED, "mu = 1/100000"),
        (TUNED, "mu = 1/1000"),
        (TUNED, "mu = 1/20"),
        (TUNED, "mu = 1"),
        (TUNED, "mu = 100"),
        (SHAKEN, "mu = 1/1000"),
        (SHAKEN, "mu = 1/20"),
        (SHAKEN, "mu = 1.9"),
        (SHAKEN, "mu = 1.99"),
    ] {
        let judged = judged(kind, at);
        for own in &judged.formulas {
            let error = own.relative_error.unwrap_or(f64::NAN);
            assert!(error.abs() < 2e-6, "{kind:?} {at}: {own:?}");
        }
        assert_eq!(judged.verdict, Some(Verdict::Pass));
    }
}

/// A force for which the law is none of small changes is not judged.
#[test]
fn a_law_of_small_changes_is_not_judged_of_large_ones() {
    for force in ["1", "1/100000"] {
        let judged =
            judged(AbsorberKind::Nonlinear, &format!("mu = 1/20, alpha3 = 1, F = {force}"));
        let cubic = judged.formulas.iter().find(|own| own.name == "cubic").expect("a formula");
        assert_eq!((cubic.truth, judged.verdict), (None, None), "F = {force}");
    }
}

/// A heavier main mass than doubles resolve is no pass.
#[test]
fn what_is_not_found_is_not_judged() {
    let judged = judged(TUNED, "mu = 1/100000000");
    assert!(judged.formulas.iter().all(|own| own.truth.is_none()));
    assert_eq!(judged.verdict, None);
}

/// On a damped main mass the design of the lowest variance is found again by a search, with an error in
/// proportion to the square of the damping.
#[test]
fn a_damped_main_mass_moves_the_lowest_variance() {
    for excitation in [Excitation::Force, Excitation::Ground] {
        for mu in ["1/50", "1/5"] {
            let errors = |damping: &str| {
                let at = format!("mu = {mu}, zeta_1 = {damping}");
                let judged = judged(AbsorberKind::Damped(excitation), &at);
                assert_eq!(judged.formulas.len(), 3);
                ["tuning", "variance"].map(|name| {
                    let own = judged.formulas.iter().find(|own| own.name == name);
                    own.and_then(|own| own.relative_error).expect("an error").abs()
                })
            };
            let [tuning, variance] = errors("1/100");
            let [of_half, variance_of_half] = errors("1/200");
            // The search knows the tuning to a millionth.
            let quarter = |one: f64, other: f64| one < 0.35 * other + 2e-6;
            assert!(quarter(of_half, tuning), "{excitation:?} {mu}: {tuning} {of_half}");
            assert!(quarter(variance_of_half, variance), "{variance} {variance_of_half}");
            assert!(tuning < 1e-3 && variance < 1e-2, "{excitation:?} {mu}: {tuning} {variance}");
            // The damping of the main mass matters: the design without it is farther off.
            let plain = value(
                AbsorberKind::Tuned(excitation),
                &format!("mu = {mu}"),
                "lowest-variance",
                "tuning",
            );
            let at = format!("mu = {mu}, zeta_1 = 1/100");
            let judged = judged(AbsorberKind::Damped(excitation), &at);
            let found = truth(&judged, "lowest-variance", "tuning");
            assert!((plain / found - 1.0).abs() > 3.0 * tuning);
        }
    }
}

/// The highest response of a main mass with a tuned mass damper, over the static one, from the two
/// equations by Cramer's rule at closely spaced frequencies.
fn highest_response(shaken: bool, mu: f64, own_damping: f64, [f, zeta]: [f64; 2]) -> f64 {
    let response = |g: f64| {
        let i = Complex64::i();
        let link = f * f + 2.0 * zeta * f * g * i;
        let stiffness = [
            [1.0 - g * g + 2.0 * own_damping * g * i + mu * link, -mu * link],
            [-link, link - g * g],
        ];
        let force = [1.0, if shaken { 1.0 } else { 0.0 }];
        let determinant = stiffness[0][0] * stiffness[1][1] - stiffness[0][1] * stiffness[1][0];
        ((force[0] * stiffness[1][1] - force[1] * stiffness[0][1]) / determinant).norm()
    };
    let grid = (1..20_000).map(|step| response(f64::from(step) * 1e-4));
    grid.fold(0.0, f64::max) / response(0.0)
}

/// Where the lowest peak has no formula its search ends at a design to every side of which the highest
/// response is higher, and which tends to the formulas as the damping of the main mass tends to 0.
#[test]
fn a_lowest_peak_without_a_formula_is_searched() {
    let searched = |kind, at: &str| judged(kind, at).lowest_peak.expect("a peak");
    for (excitation, own_damping) in
        [(Excitation::Force, 0.02), (Excitation::Ground, 0.02), (Excitation::Ground, 0.0)]
    {
        let shaken = excitation == Excitation::Ground;
        for mu in [0.02, 0.2] {
            let found = match own_damping > 0.0 {
                true => {
                    let at = format!("mu = {mu}, zeta_1 = {own_damping}");
                    searched(AbsorberKind::Damped(excitation), &at)
                }
                false => searched(AbsorberKind::Tuned(excitation), &format!("mu = {mu}")),
            };
            let height = |[f, zeta]: [f64; 2]| {
                let design = [f * found.tuning, zeta * found.damping];
                highest_response(shaken, mu, own_damping, design)
            };
            let least = height([1.0, 1.0]);
            assert!((found.height / least - 1.0).abs() < 1e-6, "{} {least}", found.height);
            for aside in [[0.998, 1.0], [1.002, 1.0], [1.0, 0.98], [1.0, 1.02], [0.999, 1.01]] {
                assert!(height(aside) > least, "{excitation:?} {mu} {aside:?}");
            }
        }
    }
    let plain = |name: &str| value(TUNED, "mu = 1/5", "lowest-peak", name);
    let found = searched(AbsorberKind::Damped(Excitation::Force), "mu = 1/5, zeta_1 = 0");
    for (found, wanted) in [
        (found.tuning, plain("tuning")),
        (found.damping, plain("damping")),
        (found.height, plain("height")),
    ] {
        assert!((found / wanted - 1.0).abs() < 2e-5, "{found} {wanted}");
    }
    assert_eq!(judged(TUNED, "mu = 1/5").lowest_peak, None);
}

/// What one harmonic leaves out of a cubic sink is the third one: with its first effect the formulas
/// are at least three times as near the motions with all harmonics, and most of them ten times.
#[test]
fn the_third_harmonic_is_what_one_harmonic_leaves_out() {
    for lambda in ["0.02", "0.1", "0.2", "0.35", "0.5"] {
        let judged =
            judged(AbsorberKind::CubicSink, &format!("lambda = {lambda}, k = 2, eps = 1/100"));
        let error = |design: &str, name: &str| {
            let own = judged.formulas.iter().find(|own| (own.design, own.name) == (design, name));
            own.and_then(|own| own.relative_error).expect("an error").abs()
        };
        let mut nearer = vec![];
        for design in ["upward-jump", "downward-jump"] {
            let refined = format!("{design}-with-third-harmonic");
            for name in ["amplitude", "relative_amplitude", "landing", "force", "least_force"] {
                if (design, name) == ("downward-jump", "least_force") {
                    continue;
                }
                let found = error(&refined, name);
                assert!(found < 0.005, "{lambda} {design} {name}: {found}");
                nearer.push(error(design, name) / found);
            }
        }
        nearer.sort_by(f64::total_cmp);
        assert!(nearer[0] > 2.0 && nearer[4] > 8.0, "{lambda}: {nearer:?}");
        assert_eq!(judged.verdict, Some(Verdict::Pass));
    }
}

/// The response of the equations as they are printed: their highest amplitude is h of the design.
#[test]
fn the_response_of_the_equations_has_the_height() {
    for kind in [TUNED, SHAKEN] {
        let laws = laws(kind);
        let sides = laws.equations.iter().map(|(left, right)| format!("{left} = {right}"));
        let equations = sides.collect::<Vec<_>>().join("; ");
        let at = values("mu = 1/10");
        for design in ["equal-peaks", "lowest-peak"] {
            let value = |name| laws.named_value(design, name, &at);
            let (Some(f), Some(zeta), Some(height)) =
                (value("tuning"), value("damping"), value("height"))
            else {
                continue;
            };
            let static_one = if kind == TUNED { 1.0 } else { 1.1 };
            let numbers = format!("mu = 1/10, f = {f}, zeta = {zeta}");
            let request =
                ResponseRequest::new(&equations, "g", [0.6, 1.4], &numbers).expect("a question");
            let found = respond(&request).expect("a response");
            let points = found.branches.iter().flat_map(|branch| &branch.points);
            let highest = points.map(|point| point.coordinates[0].peak).fold(0.0, f64::max);
            let relative = highest / static_one / height;
            // Fixed points lie a little below the peaks; the branch has points a little beside them.
            assert!((0.999..1.003).contains(&relative), "{kind:?} {design}: {relative}");
        }
    }
}

/// The cubic spring that makes the true peaks equally high tends to that of the formula in proportion
/// to alpha3 F^2, the heights quadratically; with the linear spring alone the peaks are apart.
#[test]
fn similar_springs_keep_the_peaks_of_the_response_equal() {
    let mu = 0.05_f64;
    let errors = [1.0, 4.0].map(|part| {
        let at = format!("mu = {mu}, alpha3 = 4, F = {}", 0.005 * part);
        let judged = judged(AbsorberKind::Nonlinear, &at);
        let error = |name| {
            let own = judged.formulas.iter().find(|own| own.name == name);
            own.and_then(|own| own.relative_error).expect(name).abs()
        };
        let [lower, upper] =
            ["lower_height", "upper_height"].map(|name| truth(&judged, "similar-springs", name));
        let linear = judged.curves.iter().find(|curve| curve.label.starts_with("linear"));
        let linear = &linear.expect("a curve").points;
        let top = |from: f64, to: f64| {
            let near = linear.iter().filter(|point| (from..to).contains(&point.0));
            near.map(|point| point.1).fold(0.0, f64::max)
        };
        let middle = 1.0 / (1.0 + mu).sqrt();
        let apart = (top(0.0, middle) / top(middle, 9.0)).ln().abs();
        let own = (lower / upper).ln().abs();
        assert!(own < apart / 8.0, "{at}: {own}, {apart}");
        [error("cubic"), error("lower_height").max(error("upper_height"))]
    });
    let [near, far] = errors;
    assert!(near[0] < 0.02 && near[0] < far[0] / 8.0, "{mu}: {errors:?}");
    assert!(near[1] < far[1] / 64.0, "{mu}: {errors:?}");
}

/// A ball without mass in a cavity that moves as `C cos t`, followed here with small steps: whether
/// the walls are hit in turn, half a period apart, at last.
fn keeps_step(restitution: f64, amplitude: f64, ball: f64) -> bool {
    const STEPS: usize = 4_000;
    let loss = (1.0 - restitution) / (1.0 + restitution);
    let (x, rate) = (ball - 1.0, 2.0 * loss * ball / PI);
    let scale = amplitude / x.hypot(rate);
    // Just off the motion of the manifold.
    let mut t = rate.atan2(x) + 1e-4;
    let mut y = scale * x + 1.0;
    let mut velocity = -2.0 * ball / PI;
    let mut side = 1.0;
    for _ in 0..400 {
        let step = PI / STEPS as f64;
        let relative = |time: f64| y + velocity * (time - t) - amplitude * time.cos();
        let mut time = t + 10.0 * step;
        while relative(time).abs() < 1.0 {
            time += step;
            if time > t + 2.0 * PI {
                return false;
            }
        }
        let (mut low, mut high) = (time - step, time);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if relative(middle).abs() < 1.0 { low = middle } else { high = middle }
        }
        let hit = relative(high).signum();
        if hit == side || (high - t - PI).abs() > 0.5 {
            return false;
        }
        y += velocity * (high - t);
        let wall = -amplitude * high.sin();
        velocity = wall - restitution * (velocity - wall);
        let change = (high - t - PI).abs();
        (t, side) = (high, hit);
        if change > 0.05 {
            return false;
        }
    }
    true
}

#[test]
fn a_ball_keeps_step_between_the_two_amplitudes() {
    for restitution in [0.4, 0.65, 0.8] {
        let at = format!("r = {restitution}, b = 1, mu = 1/100");
        let kind = AbsorberKind::ImpactSink;
        let least = value(kind, &at, "threshold", "amplitude");
        let most = value(kind, &at, "period-doubling", "amplitude");
        let loss = (1.0 - restitution) / (1.0 + restitution);
        let ball = |amplitude: f64| {
            let square = PI * PI + 4.0 * loss * loss;
            let root = amplitude * amplitude * square - 4.0 * loss * loss;
            PI * (PI + root.max(0.0).sqrt()) / square
        };
        for (amplitude, keeps) in [
            (0.97 * least, false),
            (1.03 * least, true),
            ((least + most) / 2.0, true),
            (0.97 * most, true),
            (1.05 * most, false),
        ] {
            let kept = keeps_step(restitution, amplitude, ball(amplitude));
            assert_eq!(kept, keeps, "r = {restitution}, C = {amplitude} of {least} to {most}");
        }
    }
}

#[test]
fn impacts_without_mass_follow_the_manifold_exactly() {
    for at in [
        "r = 0.65, b = 1, mu = 1/1000",
        "r = 0.1, b = 3, mu = 1/100",
        "r = 0.99, b = 1, mu = 1/1000",
    ] {
        let judged = judged(AbsorberKind::ImpactSink, at);
        for own in &judged.formulas {
            let error = own.relative_error.unwrap_or(f64::NAN);
            assert!(error.abs() < 1e-6, "{at}: {own:?}");
        }
    }
    // A lighter ball stays closer to it.
    let distance = |mu: &str| {
        let judged = judged(AbsorberKind::ImpactSink, &format!("r = 0.65, b = 1, mu = {mu}"));
        judged.motion.expect("a motion").largest_distance
    };
    let distances = ["1/50", "1/500", "1/5000"].map(distance);
    assert!(distances.is_sorted_by(|one, other| one > other), "{distances:?}");
    assert!(distances[2] < 0.01, "{distances:?}");
}

/// The folds of the sink beside a main mass that moves as `C cos t` are those of a driven oscillator,
/// followed by another solver.
#[test]
fn folds_of_the_sink_are_those_of_a_driven_oscillator() {
    for (at, numbers) in [
        ("lambda = 1/5, k = 1, eps = 1/100", "lambda = 1/5, k = 1"),
        ("lambda = 3/10, k = 4, eps = 1/100", "lambda = 3/10, k = 4"),
    ] {
        let judged = judged(AbsorberKind::CubicSink, at);
        let equation = "z'' + lambda*z' + k*z^3 = C*cos(t)";
        let request =
            ResponseRequest::new(equation, "C", [0.05, 0.8], numbers).expect("a question");
        let found = respond(&request).expect("a response");
        let folds = found.bifurcations.iter().filter(|place| place.kind == BifurcationKind::Fold);
        let folds: Vec<f64> = folds.map(|place| place.parameter).collect();
        for design in ["upward-jump", "downward-jump"] {
            let own = truth(&judged, design, "amplitude");
            assert!(
                folds.iter().any(|fold| (fold - own).abs() < 1e-5),
                "{at} {design}: {own}, {folds:?}"
            );
        }
        // One harmonic is a few per cent off.
        for own in &judged.formulas {
            assert!(own.relative_error.is_some_and(|error| error.abs() < 0.06), "{at}: {own:?}");
        }
    }
}

/// The state of both masses of a cubic sink, lambda = 1/5 and k = 1, after a period of the force.
fn after_a_period(state: [f64; 4], force: f64, mass_ratio: f64) -> [f64; 4] {
    let rates = |t: f64, state: &[f64; 4], out: &mut [f64; 4]| {
        let [x, y, u, v] = *state;
        let link = (u - v) / 5.0 + (x - y).powi(3);
        *out = [u, v, mass_ratio * (force * t.cos() - link) - x, link];
    };
    let start = Point { t: 0.0, y: state };
    let options = IntegrationOptions::with_tolerance(1e-12);
    integrate_first_order(rates, start, 2.0 * PI, &[], &options).expect("a path").end().y
}

/// The largest multiplier of the steady motion near that of one harmonic.
fn largest_multiplier(force: f64, mass_ratio: f64) -> f64 {
    // S (lambda^2 + 9 S^2/16) = F^2, Z = F/(i lambda + 3 S/4), X = Z (1 - 3 S/4 - i lambda).
    let balance = |square: f64| square * (0.04 + 0.5625 * square * square) - force * force;
    let square = find_root(balance, 0.0, 4.0).expect("a root");
    let z = force / Complex64::new(0.75 * square, 0.2);
    let x = z * Complex64::new(1.0 - 0.75 * square, -0.2);
    let y = x - z;
    let mut state = Vector4::new(x.re, y.re, -x.im, -y.im) * 0.988;
    let jacobian = |state: &Vector4<f64>| {
        const STEP: f64 = 1e-5;
        let mut jacobian = Matrix4::zeros();
        for column in 0..4 {
            let shifted = |sign: f64| {
                let mut state = *state;
                state[column] += sign * STEP;
                Vector4::from(after_a_period(state.into(), force, mass_ratio))
            };
            jacobian.set_column(column, &((shifted(1.0) - shifted(-1.0)) / (2.0 * STEP)));
        }
        jacobian
    };
    for _ in 0..20 {
        let left = Vector4::from(after_a_period(state.into(), force, mass_ratio)) - state;
        let step = (jacobian(&state) - Matrix4::identity()).lu().solve(&left).expect("a step");
        state -= step;
        if step.norm() < 1e-9 {
            let multipliers = jacobian(&state).complex_eigenvalues();
            return multipliers.iter().map(|own| own.norm()).fold(0.0, f64::max);
        }
    }
    f64::NAN
}

/// The steady motions of both masses, in full, are stable up to the force of the lower fold and from
/// that of the upper fold on.
#[test]
fn no_steady_motion_is_stable_between_the_forces_of_the_folds() {
    let judged = judged(AbsorberKind::CubicSink, "lambda = 1/5, k = 1, eps = 1/500");
    let (lower, upper) =
        (truth(&judged, "upward-jump", "force"), truth(&judged, "downward-jump", "force"));
    for (force, is_stable) in [
        (0.9 * lower, true),
        (0.98 * lower, true),
        (1.02 * lower, false),
        ((lower + upper) / 2.0, false),
        (0.98 * upper, false),
        (1.02 * upper, true),
    ] {
        let multiplier = largest_multiplier(force, 1.0 / 500.0);
        assert_eq!(multiplier < 1.0, is_stable, "F = {force}: {multiplier}");
        assert!(multiplier.is_finite());
    }
}

/// Along the manifold both masses move slowly; the slower, the lighter the sink.
#[test]
fn a_light_sink_slides_along_its_manifold() {
    let distance = |eps: &str| {
        let judged = judged(AbsorberKind::CubicSink, &format!("lambda = 1/5, k = 1, eps = {eps}"));
        judged.motion.expect("a motion")
    };
    let (heavy, light) = (distance("1/50"), distance("1/1000"));
    assert!(light.largest_distance < heavy.largest_distance, "{heavy:?} {light:?}");
    let end = value(
        AbsorberKind::CubicSink,
        "lambda = 1/5, k = 1, eps = 1/1000",
        "downward-jump",
        "amplitude",
    );
    assert!((light.end / end - 1.0).abs() < 0.06, "{light:?} {end}");
}

/// The time in which the amplitude of the main mass falls by the energy that the impacts of a ball or a
/// pendulum take: the error falls with its mass.
#[test]
fn sinks_decay_along_their_manifold_as_impacts_take_energy() {
    for (kind, letters) in [
        (AbsorberKind::ImpactSink, "r = 3/10"),
        (AbsorberKind::ImpactSink, "r = 13/20"),
        (AbsorberKind::PendulumSink, "r = 13/20, w = 1/2"),
        (AbsorberKind::PendulumSink, "r = 4/5, w = 7/10"),
    ] {
        let error = |mu: &str| {
            let judged = judged(kind, &format!("{letters}, b = 1, mu = {mu}"));
            let decay = judged.motion.and_then(|motion| motion.decay).expect("a decay");
            decay.formula / decay.truth - 1.0
        };
        let (heavy, light) = (error("1/1000"), error("1/8000"));
        assert!(
            heavy.abs() < 0.03 && light.abs() < 0.25 * heavy.abs(),
            "{letters}: {heavy} {light}"
        );
    }
}

/// A pendulum that hardly swings by itself is the ball.
#[test]
fn a_slow_pendulum_is_the_ball_in_a_cavity() {
    let numbers = |kind, letters: &str| {
        let judged = judged(kind, letters);
        assert_eq!(judged.verdict, Some(Verdict::Pass), "{letters}");
        judged.formulas.iter().map(|own| own.truth.expect("a truth")).collect::<Vec<f64>>()
    };
    let ball = numbers(AbsorberKind::ImpactSink, "r = 13/20, b = 1, mu = 1/100");
    let pendulum = numbers(AbsorberKind::PendulumSink, "r = 13/20, b = 1, w = 1/10000, mu = 1/100");
    for (ball, pendulum) in ball.into_iter().zip(pendulum) {
        assert!((pendulum / ball - 1.0).abs() < 1e-6, "{pendulum} {ball}");
    }
}

/// Neither the formula nor the search has a largest stable amplitude where no multiplier reaches -1: the
/// motion ends where the pendulum reaches the other barrier between its impacts, by its closed form.
#[test]
fn a_pendulum_near_the_frequency_of_the_main_mass_touches_before_it_is_unstable() {
    let judged = judged(AbsorberKind::PendulumSink, "r = 1/2, b = 1, w = 19/20, mu = 1/1000");
    let rows = judged.formulas.iter().filter(|own| own.design == "period-doubling");
    for own in rows {
        assert_eq!((own.value, own.truth), (None, None), "{own:?}");
    }
    assert_eq!(judged.verdict, Some(Verdict::Pass));
    let (r, w) = (0.5_f64, 0.95_f64);
    let (s, forced) = ((1.0 - r) / (1.0 + r), 1.0 - w * w);
    let kappa = w / (PI * w / 2.0).tan();
    let farthest = |z: f64| {
        let y = |t: f64| {
            let own = z * (w * (PI / 2.0 - t)).sin() / (PI * w / 2.0).sin();
            own - (z - 1.0) * t.cos() + s * kappa * z * t.sin()
        };
        (10..1990).map(|place| y(PI * f64::from(place) / 2000.0).abs()).fold(0.0, f64::max)
    };
    let touch = judged.touch.expect("a touch");
    assert!(farthest(0.99 * touch.sink) < 1.0 && farthest(1.01 * touch.sink) > 1.0, "{touch:?}");
    let amplitude = forced * (touch.sink - 1.0).hypot(s * kappa * touch.sink);
    assert!((touch.amplitude / amplitude - 1.0).abs() < 1e-12);
}

#[test]
fn values_outside_their_range_are_refused() {
    for (kind, at, words) in [
        (TUNED, "mu = -1/20", "mu = -1/20: the mass ratio is positive"),
        (TUNED, "mu = 0", "mu = 0: the mass ratio is positive"),
        (SHAKEN, "mu = 2", "mu = 2: the mass ratio on shaken ground is above 0 and below 2"),
        (
            AbsorberKind::ImpactSink,
            "r = 1, b = 1, mu = 1/100",
            "r = 1: the coefficient of restitution is above 0 and below 1",
        ),
        (AbsorberKind::ImpactSink, "r = 1/2, b = 1", "`mu` has no value"),
        (
            AbsorberKind::CubicSink,
            "lambda = 0.6, k = 1, eps = 1/100",
            "a sink whose manifold folds",
        ),
        (
            AbsorberKind::Nonlinear,
            "mu = 1/20, alpha3 = 0, F = 1/100",
            "alpha3 = 0: the cubic coefficient of a main mass that stiffens is positive",
        ),
        (TUNED, "mu = 1/20, nu = 1", "`nu` is no letter of this absorber, which has `mu`"),
    ] {
        let error: AbsorberError =
            judge_absorber(&laws(kind), &values(at), 0.01).expect_err("a refusal");
        assert!(error.to_string().contains(words), "{at}: {error}");
    }
}

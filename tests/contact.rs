//! One impact of the pendulum, from equation (8) to the verdict: the closed forms against the true motion and against
//! numbers found independently.

use std::f64::consts::PI;

use lindstedt::impact::Rule;
use lindstedt::impact::hertz::{self, Design, elastic_force};
use lindstedt::impact::{self, Setup};
use lindstedt::impact::{ContactSpeed, Form, Swing, ThreePhases, three_phases};
use lindstedt::impact::{TrueImpact, deviation, true_impact};
use lindstedt::numeric::ode::Options;
use proptest::prelude::*;

const SINE: fn(f64) -> f64 = f64::sin;

fn swing(amplitude: f64, barrier: f64, stiffness: f64) -> Swing<'static> {
    Swing {
        amplitude,
        barrier,
        stiffness,
        frequency_squared: 1.0 - amplitude * amplitude / 8.0,
        linear_stiffness: 1.0,
        restoring_force: &SINE,
        elastic_force: &elastic_force,
        rule: Rule::LeastSquares,
    }
}

fn paper(stiffness: f64, column: ContactSpeed) -> ThreePhases {
    three_phases(&swing(1.5, 0.323, stiffness), column).unwrap()
}

fn truth(stiffness: f64) -> TrueImpact {
    true_impact(
        1.5,
        0.323,
        stiffness,
        f64::sin,
        elastic_force,
        &Options::with_tolerance(1e-12),
    )
    .unwrap()
}

#[test]
fn table_5_leads_to_the_depth_and_duration_of_a_hertz_contact() {
    let stiffness = Design::default().stiffness().unwrap();
    assert!((stiffness / 3.0407e7 - 1.0).abs() < 2e-5);
    for (column, depth, duration) in [
        (ContactSpeed::Paper, 1.32079e-3, 3.13035e-3),
        (ContactSpeed::Energy, 1.39090e-3, 3.09013e-3),
    ] {
        let speed = paper(stiffness, column).speed;
        assert!(
            (hertz::penetration(stiffness, speed).unwrap() - depth).abs() < 6e-9,
            "{column}: depth"
        );
        assert!(
            (hertz::duration(stiffness, speed).unwrap() - duration).abs() < 6e-9,
            "{column}: duration"
        );
    }
}

#[test]
fn contact_times_over_many_decades_of_stiffness() {
    // Values known from interval arithmetic.
    assert!((truth(1e6).duration - 0.012_106_027_06).abs() < 1e-10);
    assert!((truth(4.2e9).duration - 4.30387e-4).abs() < 1e-9);
    for power in [3, 5, 7, 9, 11, 14, 18] {
        let stiffness = 10.0_f64.powi(power);
        let truth = truth(stiffness);
        // Gravity shortens the depth by sin(x_c) d against v^2/2: Hertz alone is right for stiff barriers.
        let depth = hertz::penetration(stiffness, truth.touch.v).unwrap();
        let gravity = depth * 1.5_f64.sin();
        assert!(
            (truth.penetration / depth - 1.0).abs() < 2.0 * gravity + 1e-6,
            "depth at gamma = {stiffness}"
        );
        let duration = hertz::duration(stiffness, truth.touch.v).unwrap();
        assert!(
            (truth.duration / duration - 1.0).abs() < 2.0 * gravity + 1e-6,
            "duration at gamma = {stiffness}"
        );
        // And the closed form with the energy's speed: 1.6 % long, the least-squares line's own error.
        let closed = paper(stiffness, ContactSpeed::Energy);
        assert!(
            (closed.duration / duration - 1.016).abs() < 2.0 * gravity + 1e-3,
            "line at gamma = {stiffness}"
        );
    }
}

#[test]
fn the_printed_contact_duration_needs_an_absurd_stiffness() {
    // 9.258e-8 as dimensionless time belongs to gamma = 6.2e18 in a Hertz contact of the true speed.
    let truth = truth(6.2e18);
    assert!(
        (truth.duration / 9.258e-8 - 1.0).abs() < 0.002,
        "duration {}",
        truth.duration
    );
    assert!((hertz::duration(6.2e18, truth.touch.v).unwrap() / truth.duration - 1.0).abs() < 1e-6);
    // And the slope 0.034 of equation (15) to the depth 1.093e-3, gamma = 4.88e7.
    let speed = paper(1e6, ContactSpeed::Paper).speed;
    let line = paper(4.88e7, ContactSpeed::Paper).line;
    assert!((line.slope - 0.034).abs() < 2e-5, "slope {}", line.slope);
    assert!((hertz::penetration(4.88e7, speed).unwrap() - 1.093e-3).abs() < 1e-6);
}

#[test]
fn the_errors_of_the_paper_have_the_sizes_known() {
    let stiffness = Design::default().stiffness().unwrap();
    let (closed, truth) = (paper(stiffness, ContactSpeed::Paper), truth(stiffness));
    let percent = |value: f64, reference: f64| 100.0 * (value / reference - 1.0);
    assert!((percent(closed.speed, truth.touch.v) + 6.26).abs() < 0.005);
    assert!((percent(closed.phases[0].end, truth.touch.t) - 2.15).abs() < 0.005);
    // Away from the barrier's neighbourhood the periods differ like the approaches.
    assert!((percent(closed.period, truth.period) - 2.15).abs() < 0.01);
}

#[test]
fn an_exact_frequency_does_not_make_the_cosine_exact() {
    // The true omega at 1.5 rad instead of the law: the wave form alone remains, and the verdict sees it.
    let exact = Swing {
        frequency_squared: 0.860_608_346_679_613_f64.powi(2),
        ..swing(1.5, 0.323, 1e6)
    };
    let truth = truth(1e6);
    let found = deviation(&three_phases(&exact, ContactSpeed::Energy).unwrap(), &truth);
    let of_law = deviation(&paper(1e6, ContactSpeed::Energy), &truth);
    assert!(
        found.total < 0.6 * of_law.total && found.total > 0.03,
        "{found:?} against {of_law:?}"
    );
}

#[test]
fn small_swings_are_described_well() {
    // Every approximation is of second order in A: the whole deviation, in units of A, falls like A^2, until only the
    // straight line in the contact is left.
    let relative = |amplitude: f64| {
        let barrier = 0.2 * amplitude;
        let options = Options {
            absolute_tolerance: 1e-13 * amplitude,
            ..Options::with_tolerance(1e-12)
        };
        let truth = true_impact(amplitude, barrier, 1e10, f64::sin, elastic_force, &options).unwrap();
        deviation(
            &three_phases(&swing(amplitude, barrier, 1e10), ContactSpeed::Energy).unwrap(),
            &truth,
        )
        .phases[0]
            / amplitude
    };
    let slope = (relative(0.4) / relative(0.2)).log2();
    assert!((slope - 2.0).abs() < 0.1, "exponent {slope}");
}

/// K of the complementary modulus k', by the arithmetic-geometric mean: as exact near k = 1 as anywhere.
fn complete_integral(complement: f64) -> f64 {
    let (mut one, mut other) = (1.0, complement);
    for _ in 0..60 {
        (one, other) = (0.5 * (one + other), (one * other).sqrt());
    }
    0.5 * PI / one
}

#[test]
fn tiny_and_nearly_upright_swings_are_judged_as_closely_as_any_other() {
    for (amplitude, barrier, stiffness) in [
        (1e-9, 0.0, 3.0407e7),
        (1e-9, 0.3e-9, 1e6),
        (1e-40, 0.0, 1e3),
        (1.5, 0.323, 1e6),
        (PI - 9.3e-5, 0.323, 3.0407e7),
        (PI - 2.65e-6, 0.323, 3.0407e7),
        (PI - 3.6e-9, -0.9, 1e5),
        (1.5, 0.323, 1e28),
    ] {
        let found = impact::solve(Setup {
            amplitude,
            barrier,
            stiffness,
            stiffness_source: String::new(),
            order: 4,
            rule: Rule::default(),
            integrator_tolerance: 1e-10,
            step_limit: 250_000,
        })
        .unwrap_or_else(|error| panic!("A = {amplitude}: {error}"));
        let near = |value: f64, expected: f64, what: &str| {
            assert!(
                (value / expected - 1.0).abs() < 1e-6,
                "{what} at A = {amplitude}: {value} against {expected}"
            );
        };
        let modulus = (0.5 * amplitude).sin();
        let angle = ((0.5 * barrier).sin() / modulus).asin();
        let touch = complete_integral((0.5 * amplitude).cos()) + ellip::ellipf(angle, modulus * modulus).unwrap();
        let speed = 2.0 * ((0.5 * (amplitude + barrier)).sin() * (0.5 * (amplitude - barrier)).sin()).sqrt();
        let truth = &found.truth;
        near(truth.touch.t, touch, "time to contact");
        near(truth.touch.v, speed, "speed");
        near(truth.period, 2.0 * touch + truth.duration, "period");
        assert!(truth.energy_drift < 1e-8, "A = {amplitude}: {}", truth.energy_drift);
        if stiffness > 1e20 {
            near(truth.duration, hertz::duration(stiffness, speed).unwrap(), "duration");
            near(
                truth.penetration,
                hertz::penetration(stiffness, speed).unwrap(),
                "depth",
            );
        }
    }
}

#[test]
fn a_barrier_just_before_the_turning_point_is_met_as_the_energy_says() {
    let setup = |amplitude: f64, barrier: f64| Setup {
        amplitude,
        barrier,
        stiffness: 1e6,
        stiffness_source: String::new(),
        order: 4,
        rule: Rule::default(),
        integrator_tolerance: 1e-10,
        step_limit: 250_000,
    };
    for distance in [1e-4, 1e-6, 1e-8] {
        let barrier = 1.5 - distance;
        let found = impact::solve(setup(1.5, barrier)).unwrap_or_else(|error| panic!("{distance}: {error}"));
        let speed = 2.0 * ((0.5 * (1.5 + barrier)).sin() * (0.5 * (1.5 - barrier)).sin()).sqrt();
        assert!(
            (found.truth.touch.v / speed - 1.0).abs() < 2e-6,
            "{distance}: {}",
            found.truth.touch.v / speed
        );
    }
    let refused = impact::solve(setup(1e-200, 0.0)).unwrap_err();
    assert!(refused.to_string().contains("scale it up"), "{refused}");
    let refused = impact::solve(Setup {
        step_limit: 3,
        ..setup(1.5, 0.323)
    })
    .unwrap_err();
    assert!(refused.to_string().contains("raise step_limit in [run]"), "{refused}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Whatever the numbers, there is an answer of finite numbers or a refusal.
    #[test]
    fn no_input_gives_a_number_that_is_none(
        amplitude in any::<f64>(), barrier in any::<f64>(), stiffness in any::<f64>(), law in any::<f64>(),
        part in -1.1..1.1_f64, ordinary in any::<bool>()
    ) {
        let mut case = swing(amplitude, barrier, stiffness.abs());
        case.frequency_squared = law.abs();
        if ordinary {
            case.amplitude = amplitude.abs() % 3.0;
            case.barrier = part * case.amplitude;
        }
        for column in [ContactSpeed::Paper, ContactSpeed::Energy] {
            match three_phases(&case, column) {
                Ok(motion) => {
                    let numbers = [motion.speed, motion.penetration, motion.duration, motion.period];
                    prop_assert!(numbers.iter().all(|number| number.is_finite()), "{motion:?}");
                    prop_assert!(motion.position_at(0.5 * motion.period).is_finite());
                    prop_assert!(motion.phases.iter().all(|phase| phase.end >= phase.start));
                }
                Err(refused) => prop_assert!(refused.to_string().len() > 20),
            }
        }
    }

    /// The contact never reaches deeper than its energy allows, and the closed form leaves where it entered.
    #[test]
    fn the_contact_ends_where_it_began(
        amplitude in 0.2..2.7_f64, part in -0.95..0.95_f64, power in 2.0..12.0_f64, rule in 0..6_usize
    ) {
        let case = Swing { rule: Rule::ALL[rule], ..swing(amplitude, part * amplitude, 10.0_f64.powf(power)) };
        let motion = three_phases(&case, ContactSpeed::Energy).unwrap();
        let contact = motion.phases[1];
        let (x, v) = contact.form.at(contact.end - contact.start);
        prop_assert!((x - case.barrier).abs() < 1e-9 * motion.penetration.max(1e-6));
        prop_assert!((v + motion.speed).abs() < 1e-9 * motion.speed);
        let Form::Oscillation { frequency, .. } = contact.form else { panic!("the contact oscillates") };
        // It turns in the middle, and the middle is the deepest point.
        let (deepest, at_rest) = contact.form.at(0.5 * (contact.end - contact.start));
        prop_assert!(at_rest.abs() < 1e-9 * motion.speed && frequency > 0.0);
        prop_assert!((deepest - case.barrier - motion.penetration).abs() < 1e-9 * motion.penetration.max(1e-6));
    }
}

//! One impact of the pendulum, from equation (8) to the verdict: the closed forms against the true
//! motion and against numbers found independently.

use std::f64::consts::PI;

use lindstedt::Oscillator;
use lindstedt::expr::parse_expression;
use lindstedt::impact::Rule;
use lindstedt::impact::contact::{ContactLaw, LossyLaw};
use lindstedt::impact::hertz::{self, StiffnessDesign, elastic_force};
use lindstedt::impact::{self, PhaseReading, Setup, Side};
use lindstedt::impact::{
    ContactLoss, DerivedContact, Integrator, LossAmount, Model, Settings, Start,
};
use lindstedt::impact::{ContactSpeed, Form, ImpactProblem, ThreePhases, three_phases};
use lindstedt::impact::{TrueImpact, deviation, true_impact};
use lindstedt::numeric::ode::IntegrationOptions;
use lindstedt::verify::Verdict;
use proptest::prelude::*;

const SINE: fn(f64) -> f64 = f64::sin;

fn swing(amplitude: f64, barrier: f64, stiffness: f64) -> ImpactProblem<'static> {
    ImpactProblem {
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
        &swing(1.5, 0.323, stiffness).collision(),
        &IntegrationOptions::with_tolerance(1e-12),
    )
    .unwrap()
}

#[test]
fn table_5_leads_to_the_depth_and_duration_of_a_hertz_contact() {
    let stiffness = StiffnessDesign::default().stiffness().unwrap();
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
        // Gravity shortens the depth by sin(x_c) d against v^2/2: Hertz alone is right for stiff
        // barriers.
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
        // And the closed form with the energy's speed: 1.6 % long, the least-squares line's own
        // error.
        let closed = paper(stiffness, ContactSpeed::Energy);
        assert!(
            (closed.duration / duration - 1.016).abs() < 2.0 * gravity + 1e-3,
            "line at gamma = {stiffness}"
        );
    }
}

#[test]
fn the_printed_contact_duration_needs_an_absurd_stiffness() {
    // 9.258e-8 as dimensionless time belongs to gamma = 6.2e18 in a Hertz contact of the true
    // speed.
    let truth = truth(6.2e18);
    assert!((truth.duration / 9.258e-8 - 1.0).abs() < 0.002, "duration {}", truth.duration);
    assert!((hertz::duration(6.2e18, truth.touch.v).unwrap() / truth.duration - 1.0).abs() < 1e-6);
    // And the slope 0.034 of equation (15) to the depth 1.093e-3, gamma = 4.88e7.
    let speed = paper(1e6, ContactSpeed::Paper).speed;
    let line = paper(4.88e7, ContactSpeed::Paper).fitted.unwrap().line;
    assert!((line.slope - 0.034).abs() < 2e-5, "slope {}", line.slope);
    assert!((hertz::penetration(4.88e7, speed).unwrap() - 1.093e-3).abs() < 1e-6);
}

#[test]
fn the_errors_of_the_paper_have_the_sizes_known() {
    let stiffness = StiffnessDesign::default().stiffness().unwrap();
    let (closed, truth) = (paper(stiffness, ContactSpeed::Paper), truth(stiffness));
    let percent = |value: f64, reference: f64| 100.0 * (value / reference - 1.0);
    assert!((percent(closed.speed, truth.touch.v) + 6.26).abs() < 0.005);
    assert!((percent(closed.phases[0].end, truth.touch.t) - 2.15).abs() < 0.005);
    // Away from the barrier's neighbourhood the periods differ like the approaches.
    assert!((percent(closed.period, truth.period) - 2.15).abs() < 0.01);
}

#[test]
fn an_exact_frequency_does_not_make_the_cosine_exact() {
    // The true omega at 1.5 rad instead of the law: the wave form alone remains, and the verdict
    // sees it.
    let exact = ImpactProblem {
        frequency_squared: 0.860_608_346_679_613_f64.powi(2),
        ..swing(1.5, 0.323, 1e6)
    };
    let truth = truth(1e6);
    let found = deviation(&three_phases(&exact, ContactSpeed::Energy).unwrap(), &truth);
    let of_law = deviation(&paper(1e6, ContactSpeed::Energy), &truth);
    assert!(found.total < 0.6 * of_law.total && found.total > 0.03, "{found:?} against {of_law:?}");
}

#[test]
fn small_swings_are_described_well() {
    // Every approximation is of second order in A: the whole deviation, in units of A, falls like
    // A^2, until only the straight line in the contact is left.
    let relative = |amplitude: f64| {
        let barrier = 0.2 * amplitude;
        let options = IntegrationOptions {
            absolute_tolerance: 1e-13 * amplitude,
            ..IntegrationOptions::with_tolerance(1e-12)
        };
        let truth = true_impact(&swing(amplitude, barrier, 1e10).collision(), &options).unwrap();
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

/// K of the complementary modulus k', by the arithmetic-geometric mean: as exact near k = 1 as
/// anywhere.
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
            release: -amplitude,
            barrier,
            stiffness,
            order: Some(4),
            ..Setup::default()
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
        let touch = complete_integral((0.5 * amplitude).cos())
            + ellip::ellipf(angle, modulus * modulus).unwrap();
        let speed = 2.0
            * ((0.5 * (amplitude + barrier)).sin() * (0.5 * (amplitude - barrier)).sin()).sqrt();
        let truth = &found.truth;
        near(truth.touch.t, touch, "time to contact");
        near(truth.touch.v, speed, "speed");
        near(truth.period, 2.0 * touch + truth.duration, "period");
        assert!(truth.energy_drift < 1e-8, "A = {amplitude}: {}", truth.energy_drift);
        if stiffness > 1e20 {
            near(truth.duration, hertz::duration(stiffness, speed).unwrap(), "duration");
            near(truth.penetration, hertz::penetration(stiffness, speed).unwrap(), "depth");
        }
    }
}

#[test]
fn a_barrier_just_before_the_turning_point_is_met_as_the_energy_says() {
    let setup = |amplitude: f64, barrier: f64| Setup {
        release: -amplitude,
        barrier,
        stiffness: 1e6,
        order: Some(4),
        ..Setup::default()
    };
    for distance in [1e-4, 1e-6, 1e-8] {
        let barrier = 1.5 - distance;
        let found = impact::solve(setup(1.5, barrier))
            .unwrap_or_else(|error| panic!("{distance}: {error}"));
        let speed = 2.0 * ((0.5 * (1.5 + barrier)).sin() * (0.5 * (1.5 - barrier)).sin()).sqrt();
        assert!(
            (found.truth.touch.v / speed - 1.0).abs() < 2e-6,
            "{distance}: {}",
            found.truth.touch.v / speed
        );
    }
    let refused = impact::solve(setup(1e-200, 0.0)).unwrap_err();
    assert!(refused.to_string().contains("scale it up"), "{refused}");
    let refused = impact::solve(Setup { step_limit: 3, ..setup(1.5, 0.323) }).unwrap_err();
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

    /// The contact never reaches deeper than its energy allows, and the closed form leaves where it
    /// entered.
    #[test]
    fn the_contact_ends_where_it_began(
        amplitude in 0.2..2.7_f64, part in -0.95..0.95_f64, power in 2.0..12.0_f64, rule in 0..6_usize
    ) {
        let case = ImpactProblem { rule: Rule::ALL[rule], ..swing(amplitude, part * amplitude, 10.0_f64.powf(power)) };
        let motion = three_phases(&case, ContactSpeed::Energy).unwrap();
        let contact = &motion.phases[1];
        let (x, v) = contact.form.phase_point_at(contact.end - contact.start);
        prop_assert!((x - case.barrier).abs() < 1e-9 * motion.penetration.max(1e-6));
        prop_assert!((v + motion.speed).abs() < 1e-9 * motion.speed);
        let Form::Oscillation { frequency, .. } = contact.form else { panic!("the contact oscillates") };
        // It turns in the middle, and the middle is the deepest point.
        let (deepest, at_rest) = contact.form.phase_point_at(0.5 * (contact.end - contact.start));
        prop_assert!(at_rest.abs() < 1e-9 * motion.speed && frequency > 0.0);
        prop_assert!((deepest - case.barrier - motion.penetration).abs() < 1e-9 * motion.penetration.max(1e-6));
    }
}

/// The grid of swings and barriers: from tiny to almost over the top, preloaded to grazing, soft to
/// hard.
#[test]
fn the_derived_phases_pass_their_judge_everywhere() {
    let mut worst = 0.0_f64;
    for amplitude in [0.1, 0.7, 1.5, 2.4, 3.0, 3.1] {
        for part in [-0.9, -0.3, 0.0, 0.215, 0.7, 0.99] {
            for stiffness in [1.0, 1e3, 3.0407e7, 1e9] {
                let barrier = part * amplitude;
                let found = impact::solve(Setup {
                    release: -amplitude,
                    barrier,
                    stiffness,
                    tolerance: 1e-3,
                    ..Setup::default()
                })
                .unwrap();
                let at = format!("A = {amplitude}, xc = {barrier}, gamma = {stiffness}");
                let index =
                    found.columns.iter().position(|column| column.reading == PhaseReading::Derived);
                let index = index.unwrap_or_else(|| panic!("{at}: {:?}", found.tried));
                assert_eq!(found.shortcomings(index, 1e-3), vec![], "{at}: {:?}", found.tried);
                // The energy knows the speed, elliptic functions the time: neither is asked by the
                // judge.
                let derived = &found.columns[index].phases;
                let speed = 2.0
                    * ((0.5 * (amplitude + barrier)).sin() * (0.5 * (amplitude - barrier)).sin())
                        .sqrt();
                let modulus = (0.5 * amplitude).sin();
                let angle = ((0.5 * barrier).sin() / modulus).asin();
                let touch = ellip::ellipk(modulus * modulus).unwrap()
                    + ellip::ellipf(angle, modulus * modulus).unwrap();
                for (value, exact) in [(derived.speed, speed), (derived.phases[0].end, touch)] {
                    worst = worst.max((value / exact - 1.0).abs());
                    assert!(
                        (value / exact - 1.0).abs() < 1.001e-3,
                        "{at}: {value} against {exact}"
                    );
                }
            }
        }
    }
    // A bound that nothing comes near would say nothing.
    assert!(worst > 1e-4, "{worst}");
}

/// Joins of the derived phases: continuous in place to rounding, in speed to what is left of the
/// series of the contact.
#[test]
fn the_derived_phases_join() {
    for (release, barrier, side) in
        [(-1.5, 0.323, Side::Right), (1.5, -0.323, Side::Left), (-0.8, -0.5, Side::Right)]
    {
        let found = impact::solve(Setup { release, barrier, side, ..Setup::default() }).unwrap();
        let derived = &found.column(PhaseReading::Derived).unwrap().phases;
        let [approach, contact, back] = &derived.phases;
        assert!(
            (approach.phase_point_at(0.0).0 - release).abs() < 1e-12
                && approach.phase_point_at(0.0).1.abs() < 1e-12
        );
        assert!(
            (back.phase_point_at(back.end).0 - release).abs() < 1e-12
                && back.phase_point_at(back.end).1.abs() < 1e-12
        );
        for (before, after) in [(approach, contact), (contact, back)] {
            let (left, right) =
                (before.phase_point_at(before.end), after.phase_point_at(after.start));
            assert!((left.0 - right.0).abs() < 1e-12, "{left:?} {right:?}");
            assert!((left.1 - right.1).abs() < 2e-4 * derived.speed, "{left:?} {right:?}");
        }
    }
}

/// A swing seen in a mirror: the same numbers, the motion with the other sign.
#[test]
fn a_left_barrier_mirrors_a_right_one() {
    let solve = |equation: &str, release, barrier, side| {
        impact::solve(Setup {
            swing: Some(Oscillator::parse(equation).unwrap()),
            release,
            barrier,
            side,
            stiffness: 1e5,
            ..Setup::default()
        })
        .unwrap()
    };
    let right = solve("x'' + x + x^2 = 0", -0.3, 0.1, Side::Right);
    let left = solve("x'' + x - x^2 = 0", 0.3, -0.1, Side::Left);
    for (one, other) in right.quantities().iter().zip(left.quantities()) {
        assert!((one.runge_kutta / other.runge_kutta - 1.0).abs() < 1e-12, "{}", one.name);
        let closed = one.closed_forms[0] / other.closed_forms[0] - 1.0;
        assert!(closed.abs() < 1e-12, "{}", one.name);
    }
    let [one, other] = [&right, &left].map(|impact| &impact.columns[0].phases);
    for part in 0..=40 {
        let t = one.period * f64::from(part) / 40.0;
        assert!((one.position_at(t) + other.position_at(t)).abs() < 1e-12);
    }
}

/// x'' + x^3 = 0 has its motion in elliptic functions, and its contact with a cone d^2 its energy:
/// x'^2/2 = (A^4 - x^4)/4.
#[test]
fn a_swing_and_a_barrier_of_the_users_own() {
    let found = impact::solve(Setup {
        swing: Some(Oscillator::parse("x'' + x^3 = 0").unwrap()),
        values: "k = 1e4".parse().unwrap(),
        force: Some(lindstedt::expr::parse_expression("k*d^2").unwrap()),
        release: -1.2,
        barrier: 0.3,
        tolerance: 1e-4,
        ..Setup::default()
    })
    .unwrap();
    let speed = ((1.2_f64.powi(4) - 0.3_f64.powi(4)) / 2.0).sqrt();
    assert!((found.truth.touch.v / speed - 1.0).abs() < 1e-9);
    // cn(u, m = 1/2) with u = A t: the time from -A to 0 is K/A, that from 0 to x is F(asin ..)/A.
    let quarter = ellip::ellipk(0.5).unwrap() / 1.2;
    let to_barrier = {
        let cosine = 0.3 / 1.2_f64;
        quarter - ellip::ellipf(cosine.acos(), 0.5).unwrap() / 1.2
    };
    assert!((found.truth.touch.t / (quarter + to_barrier) - 1.0).abs() < 1e-9);
    let depth = found.truth.penetration;
    let energy = |x: f64| 0.25 * x.powi(4);
    let left = 0.5 * speed * speed + energy(0.3) - energy(0.3 + depth) - 1e4 * depth.powi(3) / 3.0;
    assert!(left.abs() < 1e-9, "{left}");
    let derived = found.column(PhaseReading::Derived).unwrap();
    assert!((derived.phases.penetration / depth - 1.0).abs() < 1e-4);
    // Mass counts as it is written: 2 x'' + ... with twice every force is the same motion.
    let doubled = impact::solve(Setup {
        swing: Some(Oscillator::parse("2*x'' + 2*x^3 = 0").unwrap()),
        values: "k = 2e4".parse().unwrap(),
        ..found.setup.clone()
    })
    .unwrap();
    assert!((doubled.truth.period / found.truth.period - 1.0).abs() < 1e-12);
}

/// A contact force that is a difference of nearly equal numbers near the touch: the energy of its
/// Taylor series, which cancels nowhere, is taken up at the greatest depth, from soft barriers to
/// hard ones.
#[test]
fn a_force_that_is_a_difference_near_the_touch_keeps_its_digits() {
    /// Coefficient and power of the depth of the n-th term of a force over k, or nothing where that
    /// is the last one.
    type Term = fn(u32) -> (f64, f64);
    fn over_factorial(n: u32) -> f64 {
        (1..=n).map(f64::from).map(f64::recip).product()
    }
    fn alternating(n: u32) -> f64 {
        if n.is_multiple_of(2) { 1.0 } else { -1.0 }
    }
    fn binomial(n: u32) -> f64 {
        (0..n).map(|j| (0.5 - f64::from(j)) / f64::from(j + 1)).product()
    }
    let forces: [(&str, Term); 11] = [
        ("k*(exp(20*d) - 1)", |n| {
            (20.0_f64.powi(n as i32 + 1) * over_factorial(n + 1), f64::from(n + 1))
        }),
        ("k*(1 - cos(d))", |n| (alternating(n) * over_factorial(2 * n + 2), f64::from(2 * n + 2))),
        ("k*(cosh(d) - 1)", |n| (over_factorial(2 * n + 2), f64::from(2 * n + 2))),
        ("k*((1 + d)^3 - 1)", |n| {
            ([3.0, 3.0, 1.0].get(n as usize).copied().unwrap_or(0.0), f64::from(n + 1))
        }),
        ("k*(exp(d) - 1 - d)", |n| (over_factorial(n + 2), f64::from(n + 2))),
        ("k*(d - sin(d))", |n| (alternating(n) * over_factorial(2 * n + 3), f64::from(2 * n + 3))),
        ("k*(exp(d^(3/2)) - 1)", |n| (over_factorial(n + 1), 1.5 * f64::from(n + 1))),
        ("k*(cosh(sqrt(d)) - 1)", |n| (over_factorial(2 * n + 2), f64::from(n + 1))),
        ("k*(sqrt(d + d^2) - sqrt(d))", |n| (binomial(n + 1), f64::from(n) + 1.5)),
        ("k*(1 - cos(d))/d", |n| {
            (alternating(n) * over_factorial(2 * n + 2), f64::from(2 * n + 1))
        }),
        ("k*(exp(d) - 1 - d - d^2/2 - d^3/6)", |n| (over_factorial(n + 4), f64::from(n + 4))),
    ];
    let energy = 0.323_f64.cos() - 1.5_f64.cos();
    for (text, term) in forces {
        for stiffness in ["1e3", "1e7"] {
            let found = impact::solve(Setup {
                values: format!("k = {stiffness}").parse().unwrap(),
                force: Some(parse_expression(text).unwrap()),
                ..Setup::default()
            });
            let found = found.unwrap_or_else(|error| panic!("{text}, k = {stiffness}: {error}"));
            let depth = found.truth.penetration;
            let taken_up = |depth: f64| {
                let terms = (0..60).map(term);
                let sum: f64 =
                    terms.map(|(c, power)| c * depth.powf(power + 1.0) / (power + 1.0)).sum();
                stiffness.parse::<f64>().unwrap() * sum
                    + 2.0 * (0.5 * depth).sin() * (0.323 + 0.5 * depth).sin()
            };
            let left = taken_up(depth) / energy - 1.0;
            assert!(left.abs() < 1e-8, "{text}, k = {stiffness}: {left:e}");
            let derived = found.column(PhaseReading::Derived).unwrap();
            let phases = [
                taken_up(derived.phases.penetration) / energy - 1.0,
                derived.phases.duration / found.truth.duration - 1.0,
            ];
            // As closely as the swing of the derived column knows the speed of touch.
            assert!(
                phases.iter().all(|error| error.abs() < 1e-3),
                "{text}, k = {stiffness}: {phases:?}"
            );
        }
    }
}

/// The table of `docs/impact.md` is what is computed.
#[test]
fn the_page_says_what_is_computed() {
    let page = include_str!("../../docs/impact.md");
    let table = impact::compare(Setup { tolerance: 1e-3, ..Setup::default() }).unwrap();
    let mut found = 0;
    for line in page.lines().filter(|line| line.starts_with("| ") && line.ends_with(" |")) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let Some(row) = table.rows.iter().find(|row| row.title() == cells[0]) else {
            continue;
        };
        for (cell, error) in cells[1..].iter().zip(row.errors) {
            let computed = match error.abs() < 1e-9 {
                true => "< 1e-7".to_owned(),
                false => lindstedt::export::significant(100.0 * error, 3),
            };
            assert_eq!(*cell, computed, "{line}");
        }
        found += 1;
    }
    assert_eq!(found, 5);
}

/// Released pressed into the barrier: the same cycle, from its deepest point.
#[test]
fn a_release_inside_the_barrier_is_the_deepest_point_of_its_cycle() {
    let (release, barrier, stiffness) = (0.4, 0.323, 1e3_f64);
    let found = impact::solve(Setup { release, barrier, stiffness, ..Setup::default() }).unwrap();
    // cos(tp) = cos(0.4) - (2/5) gamma d^(5/2), the energy of the pendulum.
    let turning_point = -(release.cos() - 0.4 * stiffness * (release - barrier).powf(2.5)).acos();
    assert!((found.turning_point - turning_point).abs() < 1e-10, "{}", found.turning_point);
    assert!((found.truth.deepest.x - release).abs() < 1e-8);
    let derived = found.column(PhaseReading::Derived).unwrap();
    let deepest = derived.phases.position_at(0.5 * derived.phases.period);
    assert!((deepest - release).abs() < 1e-3 * (release - barrier) + 1e-6, "{deepest}");
    // Too much of a push throws it over the top, and a tiny one against gravity does not free it.
    for (release, barrier, stiffness, words) in [
        (1.5, 0.323, 1e7, "does not come to rest on the other side"),
        (-1.0, -1.2, 1e-6, "is not pushed out of it"),
    ] {
        let refused =
            impact::solve(Setup { release, barrier, stiffness, ..Setup::default() }).unwrap_err();
        assert!(refused.to_string().contains(words), "{refused}");
    }
}

/// The paper's pendulum at a barrier of this stiffness.
fn pendulum(stiffness: f64) -> Setup {
    Setup { stiffness, ..Setup::default() }
}

#[test]
fn the_derived_phases_join_by_every_law_of_the_contact() {
    for law in ContactLaw::ALL {
        for stiffness in [1e3, 1e6] {
            let setup = Setup { contact_law: law, ..pendulum(stiffness) };
            let impact = impact::solve(setup).unwrap_or_else(|error| panic!("{law}: {error}"));
            let phases = &impact.column(PhaseReading::Derived).expect("derived phases").phases;
            let [approach, contact, back] = &phases.phases;
            // Of the corrected law the depth is exact at touch, the speed nearly.
            let speed_kept = if law == ContactLaw::CorrectedPowerLaw { 1e-2 } else { 1e-4 };
            for (left, right) in [(approach, contact), (contact, back)] {
                let (before, after) =
                    (left.phase_point_at(left.end), right.phase_point_at(right.start));
                assert!((before.0 - after.0).abs() < 1e-12, "{law}: {before:?} and {after:?}");
                let jump = (before.1 - after.1).abs() / phases.speed;
                assert!(jump < speed_kept, "{law}: the speed jumps by {jump} of itself");
            }
            let Form::Contact { depth, .. } = &contact.form else {
                panic!("{law}: {:?}", contact.form)
            };
            assert!(depth.deviation <= 1e-6, "{law}: {}", depth.deviation);
            let deepest = depth.phase_point_at(0.5 * phases.duration).0;
            assert!((deepest / phases.penetration - 1.0).abs() < 3e-6, "{law}: {deepest}");
            // The swing is the same by every law: none makes up for the error of another.
            assert!(
                (phases.speed / impact.truth.touch.v - 1.0).abs() < 1e-3,
                "{law}: {}",
                phases.speed
            );
        }
    }
}

/// The numbers of a table of docs/contact.md that begins after these words: duration, depth, peak
/// force and motion, in percent.
fn table_of_the_page(words: &str) -> Vec<(String, [f64; 4])> {
    let page = include_str!("../../docs/contact.md");
    let (_, rest) = page.split_once(words).expect("the words are there");
    let lines = rest.lines().skip_while(|line| !line.starts_with("| `"));
    lines
        .take_while(|line| line.starts_with('|'))
        .map(|line| {
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            let number = |index: usize| cells[index].parse().expect("a number");
            (cells[0].trim_matches('`').to_owned(), [1, 2, 3, 4].map(number))
        })
        .collect()
}

#[test]
fn the_table_of_an_impact_is_that_of_the_page() {
    let impact =
        impact::solve(Setup { every_contact_law: true, ..pendulum(1e3) }).expect("an impact");
    let page = table_of_the_page("pendulum at a soft barrier, gamma = 1000");
    assert_eq!(page.len(), ContactLaw::ALL.len());
    assert_eq!(impact.contact_laws.len(), ContactLaw::ALL.len());
    for (row, (law, printed)) in impact.contact_laws.iter().zip(page) {
        assert_eq!(row.law.name(), law);
        let (motion, errors) = row.outcome.as_ref().expect("every law applies");
        let found = [errors.duration, errors.depth, errors.peak_force, errors.motion];
        for (found, printed) in found.into_iter().zip(printed) {
            assert!((100.0 * found - printed).abs() < 2e-4, "{law}: {found} and {printed}");
        }
        if row.law == ContactLaw::Exact {
            let truth = &impact.truth;
            assert!((motion.duration / truth.duration - 1.0).abs() < 1e-7);
            assert!((motion.depth / truth.penetration - 1.0).abs() < 1e-7);
        }
    }
    assert!(impact::solve(pendulum(1e3)).expect("an impact").contact_laws.is_empty());
}

#[test]
fn laws_of_a_power_are_refused_where_there_is_none() {
    let setup = |force: &str, law| Setup {
        force: Some(parse_expression(force).expect("a force")),
        contact_law: law,
        every_contact_law: true,
        ..Setup::default()
    };
    let refused =
        impact::solve(setup("1e6*d + 1e9*d^3", ContactLaw::PowerLaw)).expect("the paper's reading");
    assert!(refused.flight.is_none() && refused.tried.len() == 3, "{:?}", refused.tried);
    let reason = refused.tried[0].error.as_ref().expect_err("a reason");
    assert!(reason.contains("not given as a power"), "{reason}");
    let applies = |impact: &impact::Impact, law| {
        let row = impact.contact_laws.iter().find(|row| row.law == law).expect("a row");
        row.outcome.is_ok()
    };
    assert!(!applies(&refused, ContactLaw::PowerLaw) && applies(&refused, ContactLaw::Homotopy));
    // The exponent is found, whatever stands before the power.
    for (force, exponent) in [("3*gamma*d^2/7", 2.0), ("1e8*d^(7/3)", 7.0 / 3.0), ("gamma*d", 1.0)]
    {
        let found = impact::solve(setup(force, ContactLaw::PowerLaw)).expect("an impact");
        let Some(DerivedContact::Elastic(contact)) = &found.contact else {
            panic!("{force}: no contact")
        };
        let n = contact.exponent().expect("a power");
        assert!((n - exponent).abs() < 1e-12, "{force}: {n}");
        // Hard barriers: gravity is small beside them.
        assert!((contact.duration / found.truth.duration - 1.0).abs() < 2e-3, "{force}");
    }
}

/// A hard spring with a dashpot gives the restitution asked for; one that does not pull lets go before.
#[test]
fn a_dashpot_has_the_restitution_asked_for_at_any_speed() {
    use lindstedt::impact::contact::{Dashpot, LossyContact};
    for dashpot in Dashpot::ALL {
        for (restitution, release) in [(0.1, -1.5), (0.5, -1.5), (0.5, -0.7), (0.95, -1.5)] {
            let setup = Setup {
                loss: Some(ContactLoss {
                    law: LossyLaw::Dashpot(dashpot),
                    amount: LossAmount::Restitution(restitution),
                }),
                force: Some("gamma*d".parse().expect("a force")),
                stiffness: 1e8,
                release,
                ..Setup::default()
            };
            let found = impact::solve(setup).expect("an impact");
            let truth = found.truth.restitution();
            assert!((truth / restitution - 1.0).abs() < 2e-3, "{dashpot:?}: {truth}");
            let Some(DerivedContact::Lossy(contact)) = &found.contact else { panic!("no loss") };
            let LossyContact::Dashpot(spring) = contact.as_ref() else { panic!("no spring") };
            assert_eq!(spring.dashpot, dashpot);
            assert!((spring.duration / found.truth.duration - 1.0).abs() < 2e-3);
            assert_eq!(found.verdicts(0.02), [Verdict::Pass], "{dashpot:?} {restitution}");
        }
        let setup = Setup {
            loss: Some(ContactLoss {
                law: LossyLaw::Dashpot(dashpot),
                amount: LossAmount::Restitution(0.5),
            }),
            ..Setup::default()
        };
        let refused = impact::solve(setup).expect_err("no spring").to_string();
        assert!(refused.contains(dashpot.name()) && refused.contains("gamma*d^(3/2)"), "{refused}");
    }
}

/// Of a hard barrier every law has the restitution asked for also in the true motion; the springs reach without loss as
/// deep as the barrier, and are the barrier itself where that is a spring.
#[test]
fn every_law_that_loses_energy_has_the_restitution_asked_for() {
    use lindstedt::impact::contact::PowerLaw;
    for (force, exponent) in [("gamma*d^(3/2)", 1.5), ("gamma*d^2", 2.0), ("gamma*d", 1.0)] {
        for wanted in [0.03, 0.3, 0.7, 0.95] {
            let setup = Setup {
                force: Some(force.parse().expect("a force")),
                stiffness: 1e9,
                every_contact_law: true,
                loss: Some(ContactLoss {
                    law: LossyLaw::HuntCrossley,
                    amount: LossAmount::Restitution(wanted),
                }),
                ..Setup::default()
            };
            let found = impact::solve(setup).expect("an impact");
            assert!(found.contact_laws.is_empty());
            assert_eq!(
                found.lossy_laws.iter().map(|row| row.law).collect::<Vec<_>>(),
                LossyLaw::ALL
            );
            let lossless = PowerLaw::new(exponent, 1e9, found.energy_speed).expect("a contact");
            for row in &found.lossy_laws {
                let [_, _, _, restitution] = row.closed_form;
                assert!((restitution / wanted - 1.0).abs() < 1e-11, "{force}: {row:?}");
                // A body that comes out slowly is pushed by the swing for long.
                let allowed = match (exponent == 2.0, wanted < 0.1) {
                    (_, true) => 0.1,
                    (true, false) => 2e-2,
                    (false, false) => 5e-3,
                };
                assert!(row.errors().iter().all(|error| error.abs() < allowed), "{force}: {row:?}");
                let spring = found.energy_speed / row.stiffness.sqrt();
                match row.law {
                    LossyLaw::HuntCrossley => assert_eq!(row.stiffness, 1e9),
                    LossyLaw::Dashpot(_) => {
                        // From zeta = 1/2 on the force is greatest at the touch, gamma lambda v.
                        let at_touch = row.stiffness * row.damping * found.energy_speed;
                        let is_at_touch = row.damping * row.stiffness.sqrt() >= 1.0;
                        let off = row.runge_kutta[2] / at_touch - 1.0;
                        assert!(!is_at_touch || off.abs() < 1e-9, "{force}: {row:?}");
                        assert!((spring / lossless.depth - 1.0).abs() < 1e-9, "{force}: {row:?}");
                    }
                }
            }
            let own = &found.lossy_laws[0];
            assert!((own.runge_kutta[2] / found.greatest_force - 1.0).abs() < 1e-9, "{own:?}");
        }
    }
}

#[test]
fn the_restitution_asked_for_is_the_one_that_is_simulated() {
    for wanted in [0.05, 0.2, 0.5, 0.8, 0.95, 0.999] {
        let setup = Setup {
            loss: Some(ContactLoss {
                law: LossyLaw::HuntCrossley,
                amount: LossAmount::Restitution(wanted),
            }),
            stiffness: 1e10,
            tolerance: 1e-3,
            ..Setup::default()
        };
        let found = impact::solve(setup).unwrap_or_else(|error| panic!("{wanted}: {error}"));
        assert!(found.no_paper.is_some());
        let phases = &found.column(PhaseReading::Derived).expect("derived phases").phases;
        // By the closed form, by Runge-Kutta on the equation, and by the simulation of equation (7)
        // with its mu.
        let allowed = 3e-3 * wanted;
        assert!(
            (phases.exit_speed / phases.speed - wanted).abs() < allowed,
            "{wanted}: {}",
            phases.exit_speed
        );
        assert!(
            (found.truth.restitution() - wanted).abs() < allowed,
            "{wanted}: {}",
            found.truth.restitution()
        );
        let model = Model { gamma: 1e10, mu: 1e10 * found.damping, ..Model::default() };
        let settings = Settings { duration: 5.0, ..Settings::default() };
        let motion = impact::simulate(&model, Start::default(), Integrator::Taylor, &settings)
            .expect("a motion");
        let simulated = motion.impacts[0].restitution.expect("it bounces");
        assert!((simulated - found.truth.restitution()).abs() < 1e-6, "{wanted}: {simulated}");
        // The joins, and where it turns.
        let [approach, contact, back] = &phases.phases;
        assert!(
            (contact.phase_point_at(contact.end).1 - back.phase_point_at(back.start).1).abs()
                < 1e-3
        );
        assert!(
            (approach.phase_point_at(approach.end).0 - contact.phase_point_at(contact.start).0)
                .abs()
                < 1e-12
        );
        assert!(back.phase_point_at(back.end).1.abs() < 1e-12);
        let turn = back.phase_point_at(back.end).0;
        assert!((turn - found.place_of_turn()).abs() < 2e-3, "{wanted}: turns at {turn}");
        let verdict = found.verdicts(0.01);
        assert_eq!(verdict, [Verdict::Pass], "{wanted}: {:?}", found.shortcomings(0, 0.01));
    }
}

#[test]
fn hardly_damped_is_undamped() {
    let damped = impact::solve(Setup {
        loss: Some(ContactLoss { law: LossyLaw::HuntCrossley, amount: LossAmount::Damping(1e-12) }),
        ..pendulum(1e6)
    })
    .expect("an impact");
    let undamped = impact::solve(pendulum(1e6)).expect("an impact");
    let numbers =
        |impact: &impact::Impact| impact.quantities().map(|quantity| quantity.runge_kutta);
    for (one, other) in numbers(&damped).into_iter().zip(numbers(&undamped)) {
        assert!((one / other - 1.0).abs() < 1e-7, "{one} and {other}");
    }
    assert_eq!(damped.verdicts(0.01), [Verdict::Pass]);
    assert!(damped.truth.back.is_some() && undamped.truth.back.is_none());
}

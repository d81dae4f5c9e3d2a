//! The chain of closed forms against the integration, on cases it was not made for, and against
//! what it cannot break.

use lindstedt::impact::{
    ContactDeviation, Integrator, Model, Settings, Simulation, SimulationStop, Start, baseline,
    chain, simulate,
};
use proptest::prelude::*;

fn to_rest(duration: f64) -> Settings {
    Settings { duration, stop_at_rest: true, keep_path: false, ..Settings::default() }
}

/// The rest times by the chain and by integration.
fn rest_times(model: &Model, start: Start) -> (f64, f64) {
    let settings = to_rest(2000.0);
    let [found, truth] = [Integrator::Chain, Integrator::Taylor].map(|integrator| {
        let motion = simulate(model, start, integrator, &settings).expect("a motion");
        motion.rest().time.unwrap_or_else(|none| panic!("{none}: {model:?}"))
    });
    (found, truth)
}

#[test]
fn rest_times_are_within_a_percent_over_the_box_of_designs() {
    // gamma of Table 4: from 2.2e4 to 6.3e10. The numbers between are not those the constants were
    // tried on.
    let mut errors: Vec<f64> = Vec::new();
    for gamma in [2.2e4, 1.3e5, 8.1e5, 5.5e7, 6.3e10] {
        for zeta in [0.004, 0.0113, 0.0271, 0.05] {
            for ratio in [0.0, 0.013, 0.11, 0.3] {
                for (place, amplitude) in
                    [(0.323, 1.5), (0.12, 1.37), (0.0, 1.1), (0.55, 2.2), (0.027, 0.4)]
                {
                    let model = Model {
                        zeta,
                        gamma,
                        mu: ratio * gamma,
                        right: Some(place),
                        ..Model::default()
                    };
                    let start = Start { x: -amplitude, velocity: 0.0 };
                    let (found, truth) = rest_times(&model, start);
                    let error = found / truth - 1.0;
                    assert!(error.abs() < 0.01, "{error:+.4} at {model:?} from {amplitude}");
                    errors.push(error.abs());
                }
            }
        }
    }
    errors.sort_by(f64::total_cmp);
    assert!(errors[errors.len() / 2] < 5e-4, "median {}", errors[errors.len() / 2]);
}

/// A run that stops as soon as the rest time is known has the rest time of a longer one.
#[test]
fn stopping_at_rest_changes_no_rest_time() {
    for (zeta, alpha, right) in
        [(0.02, 0.0, Some(0.323)), (0.01, 0.01, None), (0.03, 0.0, Some(-0.05))]
    {
        let model = Model { zeta, alpha, gamma: 1e6, mu: 1e5, right, ..Model::default() };
        for integrator in [Integrator::Chain, Integrator::Taylor] {
            let [short, long] = [true, false].map(|stop_at_rest| {
                let settings = Settings { stop_at_rest, ..to_rest(400.0) };
                simulate(&model, Start::default(), integrator, &settings).expect("a motion")
            });
            assert_eq!(short.stop, SimulationStop::AtRest, "{model:?}");
            assert!(short.end_time < long.end_time);
            let [short, long] = [short, long].map(|motion| motion.rest().time.expect("it rests"));
            assert!((short - long).abs() < 1e-9, "{short} {long} {model:?}");
        }
    }
}

/// Between two barriers nearer than the level of rest it rests by definition at once, by either
/// route, and is said to be held there.
#[test]
fn a_caged_pendulum_is_said_to_be_one() {
    let caged = |right: f64| Model {
        zeta: 0.01,
        left: Some(-1e-4),
        right: Some(right),
        ..Model::default()
    };
    let start = Start { x: 0.0, velocity: 1.0 };
    let motion = |model: &Model, integrator| {
        simulate(model, start, integrator, &to_rest(50.0)).expect("a motion")
    };
    let [found, truth] =
        [Integrator::Chain, Integrator::Taylor].map(|route| motion(&caged(1e-4), route));
    assert!(found.is_caged() && truth.is_caged());
    assert_eq!((found.stop, found.impacts.len()), (SimulationStop::AtRest, truth.impacts.len()));
    assert!(baseline(&truth).expect("motions").expect("a baseline").geometry.is_none());
    assert!(!motion(&caged(0.2), Integrator::Chain).is_caged());
}

/// The gain by the shorter swing that the ratio of the actions gives is the one that is integrated.
#[test]
fn the_gain_by_geometry_is_that_of_the_lossless_barrier() {
    for (left, right, amplitude) in [
        (None, Some(0.323), 1.5),
        (None, Some(0.05), 1.5),
        (Some(-0.4), Some(0.3), 1.2),
        (Some(-0.7), None, 2.5),
    ] {
        let model = Model { zeta: 0.002, gamma: 1e8, left, right, ..Model::default() };
        let start = Start { x: 0.0, velocity: 2.0 * f64::sin(0.5 * amplitude) };
        let settings = to_rest(4000.0);
        let motion = simulate(&model, start, Integrator::Taylor, &settings).expect("a motion");
        let found = baseline(&motion).expect("motions").expect("a baseline");
        let (none, lossless) =
            (found.no_barrier.expect("rest"), found.lossless_barrier.expect("rest"));
        let gain = found.geometry.expect("viscous damping alone").gain;
        assert!((gain / (none - lossless) - 1.0).abs() < 0.02, "{gain} {none} {lossless}");
    }
}

/// The table of `docs/chain.md` is what is computed.
#[test]
fn the_page_tells_the_numbers() {
    let page = include_str!("../../../docs/chain.md");
    let mut rows = 0;
    let of_six = |line: &&str| line.starts_with("| 0") && line.matches('|').count() == 7;
    for line in page.lines().filter(of_six) {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let number =
            |index: usize| cells[index].trim_end_matches(" %").parse::<f64>().expect("a number");
        let model = Model {
            zeta: number(1),
            gamma: number(3),
            mu: number(2) * number(3),
            ..Model::default()
        };
        let (found, truth) = rest_times(&model, Start::default());
        assert!((found - number(4)).abs() < 6e-4, "{line}: {found}");
        assert!((truth - number(5)).abs() < 6e-4, "{line}: {truth}");
        assert!((100.0 * (found / truth - 1.0) - number(6)).abs() < 6e-4, "{line}");
        rows += 1;
    }
    assert_eq!(rows, 27);
}

#[test]
fn light_friction_and_two_barriers_are_as_near() {
    for (alpha, left, right) in [
        (0.002, None, Some(0.323)),
        (0.01, None, Some(0.2)),
        (0.01, Some(-0.45), Some(0.3)),
        (0.0, Some(-0.1), Some(0.6)),
        (0.005, Some(-0.5), None),
    ] {
        let model =
            Model { zeta: 0.013, alpha, gamma: 3e6, mu: 2e5, left, right, ..Model::default() };
        let start = Start { x: 0.01, velocity: 1.1 };
        let (found, truth) = rest_times(&model, start);
        assert!((found / truth - 1.0).abs() < 0.01, "{found} {truth} {model:?}");
    }
}

/// What the page says of friction: each line of its table bounds the errors over the same cases.
#[test]
fn the_page_tells_how_far_friction_lets_it_err() {
    let page = include_str!("../../../docs/chain.md");
    let (_, table) = page.split_once("| alpha/A |").expect("the table of friction");
    let mut rows = 0;
    for line in table.lines().skip(2).take_while(|line| line.starts_with('|')) {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let number =
            |index: usize| cells[index].trim_end_matches(" %").parse::<f64>().expect("a number");
        for (zeta, told) in [(0.0, number(2)), (0.02, number(3))] {
            let mut largest: f64 = 0.0;
            for right in [None, Some(-0.05), Some(0.0), Some(0.05), Some(0.323)] {
                for (amplitude, mu) in
                    [(0.4, 0.0), (1.5, 0.0), (2.2, 0.0), (0.4, 1e5), (1.5, 1e5), (2.2, 1e5)]
                {
                    let model = Model {
                        zeta,
                        alpha: number(1) * amplitude,
                        gamma: 1e6,
                        mu,
                        right,
                        ..Model::default()
                    };
                    let start = Start { x: -amplitude, velocity: 0.0 };
                    let (found, truth) = rest_times(&model, start);
                    largest = largest.max(100.0 * (found / truth - 1.0).abs());
                }
            }
            assert!((0.6..=1.0).contains(&(largest / told)), "{line}: {largest}");
        }
        rows += 1;
    }
    assert_eq!(rows, 7);
}

#[test]
fn every_contact_is_near_the_integrated_one() {
    let model = Model { zeta: 0.02, mu: 2e6, ..Model::default() };
    let settings = to_rest(300.0);
    let found = chain(&model, Start::default(), &settings).expect("a chain");
    let truth =
        simulate(&model, Start::default(), Integrator::Taylor, &settings).expect("a motion");
    assert_eq!(found.impacts.len(), truth.impacts.len());
    let deviations = found.contact_deviations(&truth);
    // The last one is a graze: its speed is small and its error is not.
    for deviation in deviations.iter().rev().skip(1) {
        let deviation = deviation.expect("the same contact");
        assert!(deviation.entry_time.abs() < 0.01, "{deviation:?}");
        for part in [deviation.speed_in, deviation.penetration] {
            assert!(part.is_some_and(|part| part.abs() < 1e-3), "{deviation:?}");
        }
        assert!(deviation.duration.is_some_and(|part| part.abs() < 1e-3), "{deviation:?}");
    }
}

/// The first contact by the chain, how far it is from the integrated one, and what the chain was
/// made of.
fn first_contact(model: &Model, start: Start) -> (Simulation, ContactDeviation) {
    let settings = Settings { duration: 20.0, ..Settings::default() };
    let found = chain(model, start, &settings).expect("a chain");
    let truth = simulate(model, start, Integrator::Taylor, &settings).expect("a motion");
    let deviations = found.contact_deviations(&truth);
    let first = deviations.first().copied().flatten().expect("a contact");
    (found, first)
}

#[test]
fn a_start_on_the_way_away_from_the_barrier_comes_back_in_time() {
    for (x, velocity) in [(-0.998, -0.559), (0.4, -1.2), (-0.1, -1.5), (0.2, -0.02)] {
        let model = Model { zeta: 0.01, gamma: 1e7, mu: 3e4, right: Some(0.5), ..Model::default() };
        let start = Start { x, velocity };
        if model.swing_energy(x, velocity) > model.swing_energy(0.5, 0.0) {
            let (_, first) = first_contact(&model, start);
            assert!(first.entry_time.abs() < 0.01, "{x} {velocity}: {first:?}");
            assert!(
                first.speed_in.is_some_and(|part| part.abs() < 0.002),
                "{x} {velocity}: {first:?}"
            );
        }
    }
}

#[test]
fn a_start_on_the_barrier_begins_with_its_contact() {
    let start = Start { x: 0.323, velocity: 0.5 };
    let model = Model { zeta: 0.01, gamma: 1e7, mu: 1e6, ..Model::default() };
    let (found, first) = first_contact(&model, start);
    assert!(found.path.pieces().iter().all(|piece| piece.closed_form().is_some()));
    assert_eq!((first.entry_time, first.speed_in), (0.0, Some(0.0)));
    assert!(first.speed_out.is_some_and(|part| part.abs() < 1e-4), "{first:?}");
    // No speed at all, and one that is lost in the energy of the place.
    for velocity in [0.0, 1e-12] {
        let start = Start { x: 0.323, velocity };
        let found = chain(&model, start, &Settings::default()).expect("a chain");
        assert!(found.end_x.is_finite() && found.stop == SimulationStop::Duration, "{found:?}");
    }
}

#[test]
fn a_tiny_swing_decays_as_any_other() {
    let model = Model { zeta: 0.02, ..Model::default() };
    let rest = |x: f64| rest_times(&model, Start { x, velocity: 0.0 });
    for amplitude in [1e-12, 1e-7, 1e-3] {
        let (found, truth) = rest(-amplitude);
        assert!((found / truth - 1.0).abs() < 1e-3, "{amplitude}: {found} {truth}");
    }
}

#[test]
fn a_contact_that_is_cut_off_has_no_error_of_its_depth() {
    let model = Model::default();
    let steps = |maximum_steps: usize| Settings { maximum_steps, ..Settings::default() };
    let found = chain(&model, Start::default(), &steps(4)).expect("a chain");
    let truth =
        simulate(&model, Start::default(), Integrator::Taylor, &steps(3)).expect("a motion");
    assert_eq!(truth.impacts.first().map(|impact| impact.exit_time), Some(None));
    let first = found.contact_deviations(&truth)[0].expect("the same contact");
    assert!(first.speed_in.is_some() && first.penetration.is_none(), "{first:?}");
}

/// A pendulum that comes to lean on a barrier beyond the bottom.
fn leaning() -> Model {
    Model { zeta: 0.02, gamma: 1e4, mu: 1e3, right: Some(-0.1), ..Model::default() }
}

#[test]
fn a_pendulum_that_leans_on_its_barrier_is_handed_to_the_integration() {
    let model = leaning();
    let settings = Settings { duration: 700.0, ..Settings::default() };
    let found = chain(&model, Start::default(), &settings).expect("a chain");
    let pieces = found.path.pieces();
    let closed = pieces.iter().take_while(|piece| piece.closed_form().is_some()).count();
    assert!(closed > 10 && closed < pieces.len(), "{closed} of {}", pieces.len());
    assert_eq!(found.stop, SimulationStop::Duration);
    let truth =
        simulate(&model, Start::default(), Integrator::Taylor, &settings).expect("a motion");
    assert!((found.end_x - truth.end_x).abs() < 1e-6, "{} {}", found.end_x, truth.end_x);
}

#[test]
fn where_the_integration_gives_up_is_told_by_the_clock_of_the_whole() {
    let model = leaning();
    let settings = Settings { duration: 700.0, maximum_steps: 300, ..Settings::default() };
    let found = chain(&model, Start::default(), &settings).expect("a chain");
    let SimulationStop::Steps { t } = found.stop else {
        panic!("{:?}", found.stop);
    };
    assert!((t - found.end_time).abs() < 1e-9, "{t} {}", found.end_time);
}

/// Energy, in units of m g L, at the knots of a chain: at turning points and at touches, where the
/// formulas know it.
fn energies(model: &Model, start: Start) -> Vec<f64> {
    let motion = chain(model, start, &to_rest(400.0)).expect("a chain");
    let mut knots: Vec<(f64, f64)> = vec![(0.0, model.energy(start.x, start.velocity))];
    for turn in motion.turns.iter().filter(|turn| model.depth(turn.x).is_none() && turn.t > 0.0) {
        knots.push((turn.t, model.energy(turn.x, 0.0)));
    }
    for impact in &motion.impacts {
        let place = model.barrier(impact.side).expect("it was touched");
        knots.push((impact.entry_time, model.energy(place, impact.speed_in)));
        if let (Some(t), Some(speed)) = (impact.exit_time, impact.speed_out) {
            knots.push((t, model.energy(place, speed)));
        }
    }
    knots.sort_by(|one, other| one.0.total_cmp(&other.0));
    knots.into_iter().map(|(_, energy)| energy).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn energy_never_grows(
        zeta in 0.0..0.3_f64,
        alpha in prop_oneof![Just(0.0), 0.0..0.2_f64],
        // Stiffer ones on which it leans are integrated for seconds: contacts of microseconds by
        // the thousand.
        gamma in 1.0..1e6_f64,
        ratio in 0.0..5.0_f64,
        right in prop_oneof![Just(None), (-0.5..2.0_f64).prop_map(Some)],
        left in prop_oneof![Just(None), (-2.0..-0.6_f64).prop_map(Some)],
        part in 0.01..0.99_f64,
        energy in 0.001..1.99_f64,
    ) {
        let model = Model { zeta, alpha, gamma, mu: ratio * gamma, left, right, ..Model::default() };
        // Somewhere between the barriers, with the rest of the energy as speed.
        let turn = 2.0 * (0.5 * energy).sqrt().asin();
        let low = left.unwrap_or(-3.0).max(-turn);
        let high = right.unwrap_or(3.0).min(turn);
        prop_assume!(low < high);
        let x = low + part * (high - low);
        let speed = (2.0 * (energy - (1.0 - x.cos()))).max(0.0).sqrt();
        let found = energies(&model, Start { x, velocity: if part < 0.5 { speed } else { -speed } });
        for pair in found.windows(2) {
            prop_assert!(pair[1] <= pair[0] * (1.0 + 1e-9) + 1e-12, "{:?} in {:?}", pair, found);
        }
    }

    #[test]
    fn a_chain_is_finite_and_in_order(
        zeta in 0.0..0.49_f64,
        alpha in 0.0..1.5_f64,
        gamma in prop_oneof![1e-6..1e3_f64, 1e3..1e15_f64],
        ratio in 0.0..1e3_f64,
        right in -1.5..3.0_f64,
        velocity in -1.9..1.9_f64,
        below in 1e-6..1.5_f64,
    ) {
        let model = Model { zeta, alpha, gamma, mu: ratio * gamma, right: Some(right), ..Model::default() };
        let start = Start { x: (right - below).max(-3.0), velocity };
        let settings = Settings { duration: 60.0, ..Settings::default() };
        if let Ok(motion) = chain(&model, start, &settings) {
            prop_assert!(motion.end_time.is_finite() && motion.end_x.is_finite() && motion.end_velocity.is_finite());
            for pair in motion.turns.windows(2) {
                prop_assert!(pair[1].t >= pair[0].t, "{pair:?}");
            }
            for impact in &motion.impacts {
                prop_assert!(impact.speed_in.is_finite() && impact.penetration.is_finite());
                prop_assert!(impact.exit_time.is_none_or(|exit| exit >= impact.entry_time));
            }
            for index in 0..100 {
                let at = motion.path.phase_point_at(motion.end_time * f64::from(index) / 100.0);
                prop_assert!(at.is_none_or(|(x, velocity)| x.is_finite() && velocity.is_finite()), "{at:?}");
            }
        }
    }
}

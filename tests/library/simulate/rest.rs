//! Rest times by their definition, from samples of the motion and from the action.

use lindstedt::impact::{Integrator, Model, NoRest, Settings, SimulationStop, Start, simulate};
use lindstedt::numeric::ode::root::find_root;

use super::{REST, run, taylor};

#[test]
fn rest_times_of_the_plain_pendulum() {
    // The envelope by the action, the staircase by the last crossing.
    for (zeta, envelope, last) in [
        (0.0100, 224.2, 223.4),
        (0.0101, 222.0, 220.3),
        (0.0102, 219.8, 217.1),
        (0.0103, 217.7, 216.9),
    ] {
        let model = Model { zeta, right: Some(3.0), ..Model::default() };
        let rest = taylor(&model, REST, 1e-10, 300.0).rest();
        assert!((rest.time.expect("it rests") - envelope).abs() < 0.06, "{rest:?}");
        assert!((rest.last_crossing.expect("it crosses") - last).abs() < 0.06, "{rest:?}");
    }
}

/// Held by friction soon after a crest above the level: when it came to rest does not change with
/// how long the run goes on.
#[test]
fn how_long_a_run_is_does_not_change_when_its_motion_rests() {
    let model = Model { alpha: 0.3, ..Model::default() };
    for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
        let [short, long] =
            [10.0, 200.0].map(|duration| run(&model, REST, 1e-12, duration, integrator).rest());
        let time = short.time.expect("it rests");
        assert!((long.time.expect("it rests") - time).abs() < 1e-9, "{short:?} {long:?}");
        // Between the last crest beyond the level and the place where it is held.
        assert!((5.0..7.5).contains(&time), "{time}");
    }
}

/// The rest time by its definition, from nothing but samples of the Runge-Kutta motion: crests on
/// the left, each by a parabola through three samples, and the straight line of log|x| between the
/// two around the level, x counted from the place of rest.
fn rest_by_samples(model: &Model, place: f64, level: f64, duration: f64) -> f64 {
    const STEP: f64 = 1e-3;
    let motion = run(model, REST, 1e-11, duration, Integrator::RungeKutta);
    let at = |k: usize| motion.path.phase_point_at(STEP * k as f64).map_or(0.0, |(x, _)| x - place);
    let crests = (1..(duration / STEP) as usize - 1).filter_map(|k| {
        let [before, here, after] = [at(k - 1), at(k), at(k + 1)];
        (here < before && here <= after).then(|| {
            let (slope, bend) = (0.5 * (after - before), before - 2.0 * here + after);
            (STEP * (k as f64 - slope / bend), here - 0.5 * slope * slope / bend)
        })
    });
    let mut before = (0.0, REST.x - place);
    for (t, x) in crests {
        if -x <= level {
            let fraction = (level / -before.1).ln() / (x / before.1).ln();
            return before.0 + fraction * (t - before.0);
        }
        before = (t, x);
    }
    f64::INFINITY
}

#[test]
fn a_barrier_near_plumb_does_not_invent_rest() {
    // Without loss nothing ever rests, wherever the barrier stands and wherever the run ends.
    for k in 0..29 {
        let model = Model { right: Some(0.005 * f64::from(k)), ..Model::default() };
        for duration in [98.5, 100.0, 101.3] {
            let rest = taylor(&model, REST, 1e-10, duration).rest();
            assert_eq!(rest.time, Err(NoRest::StaysAbove), "{:?} {duration}", model.right);
        }
    }
    for (right, mu) in [(0.1, 1e4), (0.02, 1e4), (0.146, 1e5)] {
        let model = Model { gamma: 1e6, right: Some(right), mu, zeta: 0.01, ..Model::default() };
        assert_eq!(taylor(&model, REST, 1e-10, 100.0).rest().time, Err(NoRest::StaysAbove));
        let found = taylor(&model, REST, 1e-10, 260.0).rest().time.expect("it rests");
        let sampled = rest_by_samples(&model, 0.0, 0.15, 260.0);
        assert!((found - sampled).abs() < 1e-3, "{right}: {found} {sampled}");
    }
}

#[test]
fn the_rest_time_is_continuous_in_the_place_of_the_barrier() {
    let rest = |right: f64| {
        let model =
            Model { gamma: 1e6, right: Some(right), mu: 1e5, zeta: 0.01, ..Model::default() };
        taylor(&model, REST, 1e-10, 200.0).rest().time.expect("it rests")
    };
    let times: Vec<f64> = (0..=40).map(|k| rest(0.14 + 2.5e-4 * f64::from(k))).collect();
    // It rises by a twentieth from one to the next, and so does the rise, smoothly.
    let bends = times.windows(3).map(|three| (three[0] - 2.0 * three[1] + three[2]).abs());
    assert!(bends.fold(0.0, f64::max) < 5e-3, "{times:?}");
}

#[test]
fn the_rest_time_does_not_depend_on_where_in_the_first_swing_the_motion_is_taken_up() {
    let model = Model { gamma: 1e6, mu: 1e5, right: Some(0.05), ..Model::default() };
    let whole = taylor(&model, REST, 1e-11, 900.0);
    let rest = whole.rest();
    for t in [0.5, 1.3, 1.8] {
        let (x, velocity) = whole.path.phase_point_at(t).expect("on the way");
        let later = taylor(&model, Start { x, velocity }, 1e-11, 900.0).rest();
        assert!((later.amplitude - rest.amplitude).abs() < 1e-10, "{later:?}");
        let (later, whole) = (later.time.expect("it rests"), rest.time.expect("it rests"));
        assert!((later + t - whole).abs() < 1e-5, "{t}: {later} {whole}");
    }
}

#[test]
fn a_motion_that_creeps_is_its_own_envelope_and_one_that_swings_must_be_seen_to_turn() {
    // x'' + 4 x' + x = 0 for small x: slopes s = -2 +- sqrt 3, x = (s1 e^(s2 t) - s2 e^(s1
    // t))/(s1 - s2) of the start.
    let model = Model { zeta: 2.0, right: Some(1.0), ..Model::default() };
    let start = Start { x: -1e-5, velocity: 0.0 };
    let (slow, fast) = (-2.0 + 3.0_f64.sqrt(), -2.0 - 3.0_f64.sqrt());
    let left = |t: f64| (slow * (fast * t).exp() - fast * (slow * t).exp()) / (slow - fast);
    let exact = find_root(|t| left(t) - 0.1, 1.0, 20.0).expect("it falls");
    let rest = taylor(&model, start, 1e-10, 60.0).rest();
    assert!((rest.time.expect("it rests") - exact).abs() < 1e-6, "{rest:?} {exact}");

    let swinging = Model { zeta: 0.5, ..model };
    let soon = taylor(&swinging, REST, 1e-10, 6.0).rest();
    assert_eq!(soon.time, Err(NoRest::NotYetSeen), "{soon:?}");
    assert!(taylor(&swinging, REST, 1e-10, 60.0).rest().time.is_ok());
}

/// Over the top there is no swing: the amplitude is half a turn, wherever the count of turns
/// begins.
#[test]
fn the_amplitude_of_a_motion_that_turns_over() {
    let model = Model { right: None, ..Model::default() };
    for (x, amplitude) in [-10.0, 10.0, 0.5].map(|x| (x, std::f64::consts::PI)) {
        let motion = taylor(&model, Start { x, velocity: 3.0 }, 1e-9, 5.0);
        assert!(
            (motion.rest().amplitude - amplitude).abs() < 1e-12,
            "{x}: {}",
            motion.rest().amplitude
        );
    }
}

/// Where a rest energy is given the run ends as it is reached, with what a longer run had until
/// then.
#[test]
fn a_run_ends_where_its_energy_has_died_away() {
    let plain = Model { zeta: 0.05, right: None, ..Model::default() };
    let bouncing = Model { zeta: 0.02, gamma: 1e5, mu: 1e4, ..Model::default() };
    for model in [plain, bouncing] {
        let options = Settings { duration: 200.0, ..Settings::default() };
        let full = simulate(&model, REST, Integrator::Taylor, &options).expect("a motion");
        let mut last = 0.0;
        for k in 1..14 {
            let calm = 0.9 * 0.6_f64.powi(k);
            let options = Settings { rest_energy: Some(calm), ..options };
            let motion = simulate(&model, REST, Integrator::Taylor, &options).expect("a motion");
            assert_eq!(motion.stop, SimulationStop::RestEnergy);
            let energy = model.energy(motion.end_x, motion.end_velocity);
            assert!(energy <= calm * (1.0 + 1e-9) && motion.end_time >= last, "{energy} {calm}");
            last = motion.end_time;
            let before = full.turns.iter().filter(|turn| turn.t <= motion.end_time);
            assert_eq!(motion.turns.iter().collect::<Vec<_>>(), before.collect::<Vec<_>>());
            if model.right.is_none() {
                assert!((energy / calm - 1.0).abs() < 1e-9, "{energy} {calm}");
                let judge =
                    simulate(&model, REST, Integrator::RungeKutta, &options).expect("a motion");
                assert_eq!(judge.stop, SimulationStop::RestEnergy);
                assert!((judge.end_time - motion.end_time).abs() < 1e-5);
            }
        }
    }
}

/// The same swing without a barrier and with a lossless one: the action of a lightly damped motion
/// falls as exp(-2 zeta t), so the rest times differ by the logarithm of the ratio of the actions
/// at the start, less that at the end.
#[test]
fn the_baseline_is_that_of_the_actions() {
    let settings = Settings { duration: 300.0, ..Settings::default() };
    let model = Model { zeta: 0.01, mu: 2e6, ..Model::default() };
    let motion = simulate(&model, Start::default(), Integrator::Taylor, &settings).unwrap();
    let found = lindstedt::impact::baseline(&motion).unwrap().expect("it hits and is damped");
    let (none, lossless) = (found.no_barrier.unwrap(), found.lossless_barrier.unwrap());
    // The area from the far turning point to x, 2 int sqrt(2 (cos x - cos A)) dx, by the midpoint
    // rule in the angle.
    let area = |amplitude: f64, barrier: f64| {
        let speed = |x: f64| (2.0 * (x.cos() - amplitude.cos())).max(0.0).sqrt();
        let (parts, to) = (20_000, (barrier / amplitude).clamp(-1.0, 1.0).asin());
        let half = std::f64::consts::FRAC_PI_2;
        let step = (to + half) / f64::from(parts);
        let at = |part: i32| -half + (f64::from(part) + 0.5) * step;
        2.0 * (0..parts)
            .map(|part| speed(amplitude * at(part).sin()) * amplitude * at(part).cos() * step)
            .sum::<f64>()
    };
    let whole = area(1.5, 1.5);
    let decay = |from: f64| (from / area(0.15, 0.15)).ln() / (2.0 * model.zeta);
    assert!((none / decay(whole) - 1.0).abs() < 0.01, "{none} and {}", decay(whole));
    // Cut at the barrier until its amplitude is that of the barrier, whole from there on.
    let barrier = model.right.unwrap();
    let cut = (area(1.5, barrier) / area(barrier, barrier)).ln() / (2.0 * model.zeta);
    let rest = cut + decay(area(barrier, barrier));
    assert!((lossless / rest - 1.0).abs() < 0.01, "{lossless} and {rest}");
    assert!(motion.rest().time.unwrap() < lossless && lossless < none);
    // Nothing to compare where nothing damps the swing, or nothing is hit.
    for model in [Model { zeta: 0.0, ..model }, Model { right: Some(1.6), ..model }] {
        let motion = simulate(&model, Start::default(), Integrator::Taylor, &settings).unwrap();
        assert_eq!(lindstedt::impact::baseline(&motion).unwrap(), None);
    }
}

/// Critical and stronger damping: the only fall there is, x/x_0 = (1 + t) e^-t of the linear swing,
/// and with two rates. With and without the path.
#[test]
fn motions_that_creep_rest_where_they_have_fallen_to_a_tenth() {
    let small = Start { x: -1e-4, velocity: 0.0 };
    for zeta in [1.0, 1.3, 2.0] {
        let root = f64::sqrt(zeta * zeta - 1.0);
        let fall = |t: f64| {
            let sum = match root > 0.0 {
                true => (root * t).cosh() + zeta * (root * t).sinh() / root,
                false => 1.0 + t,
            };
            sum * (-zeta * t).exp() - 0.1
        };
        let truth = find_root(fall, 0.1, 100.0).expect("it falls");
        let model = Model { zeta, ..Model::default() };
        for keep_path in [true, false] {
            let settings = Settings { duration: 60.0, keep_path, ..Settings::default() };
            let rest =
                simulate(&model, small, Integrator::Taylor, &settings).expect("a motion").rest();
            let time = rest.time.expect("it rests");
            assert!((time / truth - 1.0).abs() < 1e-8, "zeta = {zeta}: {time} and {truth}");
        }
    }
}

/// Just below critical damping the next turning point is a millionth of the first: no tenth of it
/// is reached before the motion falls to it, and nothing jumps where the damping becomes critical.
#[test]
fn no_motion_rests_before_it_has_fallen_to_a_tenth() {
    let times: Vec<f64> = [0.75, 0.8, 0.9, 0.99, 0.9999, 1.0, 1.0001]
        .into_iter()
        .map(|zeta| {
            let model = Model { zeta, ..Model::default() };
            let settings = Settings { keep_path: false, ..Settings::default() };
            let [told, untold] = [&Settings::default(), &settings].map(|settings| {
                let motion =
                    simulate(&model, REST, Integrator::Taylor, settings).expect("a motion");
                motion.rest()
            });
            let time = told.time.expect("it rests");
            assert!(
                time >= told.last_crossing.expect("it falls") - 1e-9,
                "zeta = {zeta}: {told:?}"
            );
            let same = untold.time.is_ok_and(|untold| (untold / time - 1.0).abs() < 1e-8);
            assert!(same, "zeta = {zeta}: {told:?} {untold:?}");
            time
        })
        .collect();
    assert!(times.is_sorted(), "{times:?}");
    assert!((times[4] / times[6] - 1.0).abs() < 1e-3, "{times:?}");
}

/// Where the last turning point beyond the level comes and goes the rest time as a function of the
/// friction is steep, and has no jump: wherever it changes most, it changes less the closer one
/// looks.
#[test]
fn the_rest_time_does_not_jump_where_the_last_turning_point_does() {
    for (amplitude, right, integrator) in [
        (0.4, Some(1.0), Integrator::Taylor),
        (0.4, None, Integrator::Taylor),
        (1.5, Some(0.323), Integrator::Taylor),
        (0.4, Some(1.0), Integrator::Chain),
    ] {
        let rest = |alpha: f64| {
            let model = Model { alpha, gamma: 4e5, right, ..Model::default() };
            let start = Start { x: -amplitude, velocity: 0.0 };
            let settings = Settings { duration: 100.0, keep_path: false, ..Settings::default() };
            let motion = simulate(&model, start, integrator, &settings).expect("a motion");
            motion.rest().time.expect("it rests")
        };
        let (from, to) = (0.0985 * amplitude, 0.1015 * amplitude);
        let (mut from, mut to) = (from, to);
        for _ in 0..6 {
            let alphas: Vec<f64> =
                (0..=24).map(|k| from + (to - from) * f64::from(k) / 24.0).collect();
            let times: Vec<f64> = alphas.iter().map(|alpha| rest(*alpha)).collect();
            let rise = |k: &usize| (times[k + 1] - times[*k]).abs();
            let most =
                (0..24).max_by(|one, other| rise(one).total_cmp(&rise(other))).expect("some");
            (from, to) = (alphas[most], alphas[most + 1]);
        }
        let jump = (rest(to) - rest(from)).abs();
        assert!(jump < 1e-3, "{amplitude} {right:?} {integrator:?}: {jump} at {from}");
    }
}

/// Whether the path is kept changes no rest time, by either route.
#[test]
fn a_rest_time_does_not_depend_on_whether_the_path_is_kept() {
    for integrator in [Integrator::Taylor, Integrator::Chain] {
        for k in 0..60 {
            let model = Model {
                alpha: 0.02 + 5e-4 * f64::from(k),
                zeta: 0.004 * f64::from(k % 7),
                gamma: 4e5,
                right: Some(1.0),
                ..Model::default()
            };
            let start = Start { x: -0.4, velocity: 0.0 };
            let [kept, not] = [true, false].map(|keep_path| {
                let settings = Settings { duration: 100.0, keep_path, ..Settings::default() };
                let motion = simulate(&model, start, integrator, &settings).expect("a motion");
                motion.rest().time
            });
            let same = match (kept, not) {
                (Ok(kept), Ok(not)) => (kept - not).abs() < 1e-8,
                _ => kept == not,
            };
            assert!(same, "{integrator:?} {model:?}: {kept:?} {not:?}");
        }
    }
}

/// A turn more or less is the same motion: one that begins at -4 settles at -2 pi as one that
/// begins at 2 pi - 4 does at 0.
#[test]
fn a_motion_that_goes_over_the_top_rests_where_it_settles() {
    let model = Model { zeta: 0.1, right: None, ..Model::default() };
    let turn = std::f64::consts::TAU;
    for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
        let [beyond, plain] = [-4.0, turn - 4.0].map(|x| {
            let start = Start { x, velocity: 0.0 };
            run(&model, start, 1e-12, 200.0, integrator).rest()
        });
        assert_eq!((beyond.place, plain.place), (-turn, 0.0));
        assert!((beyond.amplitude - (turn - 4.0)).abs() < 1e-12, "{beyond:?}");
        let (one, other) = (beyond.time.expect("it rests"), plain.time.expect("it rests"));
        assert!((one - other).abs() < 1e-6, "{one} {other}");
        let (one, other) =
            (beyond.last_crossing.expect("falls"), plain.last_crossing.expect("falls"));
        assert!((one - other).abs() < 1e-6, "{one} {other}");
    }
}

/// Held by a barrier before the bottom the pendulum rests there, pressed in by its weight, and that
/// is where amplitudes are counted from: the crests against samples of the other integrator, with
/// the run stopped as soon as the rest is known and not.
#[test]
fn a_pendulum_held_by_its_barrier_rests_there() {
    let model = Model { gamma: 1e5, mu: 2e4, zeta: 0.05, right: Some(-0.2), ..Model::default() };
    let depth = find_root(|d| 1e5 * d.powf(1.5) - (0.2 - d).sin(), 0.0, 0.2).expect("a depth");
    let place = -0.2 + depth;
    let level = 0.1 * (1.5 + place);
    let sampled = rest_by_samples(&model, place, level, 60.0);
    for stop_at_rest in [true, false] {
        let settings = Settings { duration: 60.0, stop_at_rest, ..Settings::default() };
        let motion = simulate(&model, REST, Integrator::Taylor, &settings).expect("a motion");
        let rest = motion.rest();
        assert!((rest.place - place).abs() < 1e-12, "{rest:?}");
        assert!((rest.amplitude - 10.0 * level).abs() < 1e-12, "{rest:?}");
        let time = rest.time.expect("it rests");
        assert!((time - sampled).abs() < 1e-3, "{time} {sampled}");
        assert_eq!(motion.stop == SimulationStop::AtRest, stop_at_rest);
    }
    // Its mirror image is the same.
    let mirrored = Model { left: Some(0.2), right: None, ..model };
    let rests = [(model, -1.5), (mirrored, 1.5)].map(|(model, x)| {
        let rest = taylor(&model, Start { x, velocity: 0.0 }, 1e-10, 60.0).rest();
        rest.time.expect("it rests")
    });
    assert!((rests[0] - rests[1]).abs() < 1e-9, "{rests:?}");
}

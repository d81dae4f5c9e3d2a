//! Events against closed forms: bounces, kicks, spikes, an escapement, and instants at which several meet.

use std::f64::consts::PI;

use lindstedt::Oscillator;
use lindstedt::coupled::CoupledEquations;
use lindstedt::event::StateEvent;
use lindstedt::system::{Integrator, PathEnd};
use lindstedt::trajectory::{
    PoincareSection, Trajectory, TrajectoryError, TrajectoryRequest, sweep,
};
use lindstedt::wall::Wall;

const BOTH: [Integrator; 2] = [Integrator::Taylor, Integrator::RungeKutta];

/// A problem with events, values `a=1 b=2` and a start.
fn course(
    equations: &str,
    events: &[&str],
    values: &str,
    start: &[(&str, f64)],
    until: f64,
) -> TrajectoryRequest {
    let course = match equations.contains(';') {
        true => TrajectoryRequest::of_coupled(&CoupledEquations::parse(equations).unwrap()),
        false => TrajectoryRequest::of_equation(&Oscillator::parse(equations).unwrap()),
    };
    let states = course.rates.states.clone();
    let event = |text: &&str| StateEvent::parse(text, &states).expect(text);
    let mut course = course.with_events(events.iter().map(event).collect());
    for pair in values.split(' ').filter(|pair| !pair.is_empty()) {
        let (name, value) = pair.split_once('=').unwrap();
        course.values.insert(name.into(), value.parse().unwrap());
    }
    for (name, value) in start {
        course.begin((*name).into(), *value).unwrap();
    }
    course.duration = until;
    course
}

fn followed(course: &TrajectoryRequest, integrator: Integrator) -> Trajectory {
    course.clone().follow_by(integrator).expect("a motion")
}

fn states(motion: &Trajectory, time: f64) -> Vec<f64> {
    motion.states_at(time).expect("a state")
}

fn times(motion: &Trajectory) -> Vec<f64> {
    motion.events.occurrences.iter().map(|event| event.time).collect()
}

fn is_near(one: f64, other: f64, error: f64) -> bool {
    (one - other).abs() <= error * other.abs().max(1.0)
}

/// A bounce written as an event is a bounce on a wall, to rounding, and its energy is accounted for.
#[test]
fn a_bounce_is_an_event() {
    for integrator in BOTH {
        let bounce = course(
            "x'' + x + x^3 + g = cos(t)",
            &["x < -1/2: x' = -e*x'"],
            "g=1 e=0.9",
            &[("x", 1.0)],
            40.0,
        );
        let wall = Wall::parse("x > -1/2", &"e".parse().unwrap()).unwrap();
        let walled = TrajectoryRequest { events: vec![], ..bounce.clone() };
        let walled = followed(&walled.with_walls(wall), integrator);
        let motion = followed(&bounce, integrator);
        assert_eq!(motion.events.occurrences.len(), walled.walls.impacts.len());
        assert!(motion.events.occurrences.len() > 10);
        for (event, impact) in motion.events.occurrences.iter().zip(&walled.walls.impacts) {
            assert!(is_near(event.time, impact.time, 1e-9), "{} {}", event.time, impact.time);
            assert!(is_near(event.before[1], -impact.speed, 1e-8));
            assert!(is_near(event.after[1], impact.departure, 1e-8));
            let (own, other) = (event.loss.unwrap(), impact.loss.unwrap());
            assert!((own - other).abs() < 1e-8, "{own} {other}");
        }
        let balance = motion.balance.as_ref().expect("an energy");
        assert!(balance.residual < 1e-10, "{}", balance.residual);
        let lost: f64 = motion.events.occurrences.iter().filter_map(|event| event.loss).sum();
        let work = balance.works.iter().find(|(name, _)| name == "events").expect("work").1;
        assert!((lost + work).abs() < 1e-12);
    }
}

/// A ball without a wall to rest on: its bounces accumulate at `sqrt(2 h/g) (1 + e)/(1 - e)`, and this is said.
#[test]
fn bounces_that_accumulate_are_said() {
    for integrator in BOTH {
        for e in [0.8_f64, 0.3, 0.01] {
            let values = format!("g=2 e={e}");
            let ball = course("x'' + g = 0", &["x < 0: x' = -e*x'"], &values, &[("x", 1.0)], 30.0);
            let motion = followed(&ball, integrator);
            assert_eq!(motion.reason(), PathEnd::EventsAccumulate, "{e}");
            let sum = (1.0 + e) / (1.0 - e);
            assert!(is_near(motion.end(), sum, 1e-9), "{e}: {} {sum}", motion.end());
            for (index, time) in times(&motion).into_iter().take(12).enumerate() {
                let closed = (1.0 + e - 2.0 * e.powi(index as i32 + 1)) / (1.0 - e);
                assert!(is_near(time, closed, 1e-11), "{e}: {time} {closed}");
            }
            assert!(states(&motion, motion.end())[0].abs() < 1e-11);
        }
    }
}

/// An oscillator that is kicked whenever it passes the middle: each half swing is a half period, and the speed grows
/// by p in the direction of the motion.
#[test]
fn kicks_in_the_middle_follow_each_other_by_half_a_period() {
    for integrator in BOTH {
        let kicked = course(
            "x'' + k^2*x = 0",
            &["x = 0: x' = x' + p*sgn(x')"],
            "k=2 p=0.1",
            &[("x", 1.0)],
            20.0,
        );
        let motion = followed(&kicked, integrator);
        let occurrences = &motion.events.occurrences;
        assert_eq!(occurrences.len(), 13);
        for (index, event) in occurrences.iter().enumerate() {
            let time = PI / 4.0 + PI / 2.0 * index as f64;
            assert!(is_near(event.time, time, 1e-11), "{} {time}", event.time);
            let speed = 2.0 + 0.1 * (index + 1) as f64;
            assert!(is_near(event.after[1].abs(), speed, 1e-10), "{:?} {speed}", event.after);
            assert!(event.loss.is_some_and(|loss| is_near(-loss, 0.1 * speed - 0.005, 1e-9)));
        }
        // Upwards alone it is every second of them.
        let upwards = course("x'' + x = 0", &["x > 0: x' = x' + 1"], "", &[("x", 1.0)], 40.0);
        let motion = followed(&upwards, integrator);
        for (index, event) in motion.events.occurrences.iter().enumerate() {
            assert!(is_near(event.time, 1.5 * PI + 2.0 * PI * index as f64, 1e-11));
            assert!(is_near(event.after[1], 2.0 + index as f64, 1e-10));
        }
        assert_eq!(motion.events.occurrences.len(), 6);
    }
}

/// A rotor that is kicked once a unit of time has the standard map, which its own states follow.
#[test]
fn a_kicked_rotor_has_its_map() {
    for integrator in BOTH {
        let events = ["sin(2*pi*t) > 0: x' = x' + K*sin(x)"];
        let mut rotor = course("x'' = 0", &events, "K=0.5", &[("x", 1.0), ("x'", 0.3)], 20.5);
        rotor.section = Some(PoincareSection::Events);
        let motion = followed(&rotor, integrator);
        // The section has the states before the kicks, at the start too.
        assert_eq!(
            (motion.crossings().len(), &motion.crossings()[0].state[..]),
            (21, &[1.0, 0.3][..])
        );
        let (mut x, mut v) = (1.0_f64, 0.3_f64);
        // The start is at a kick.
        assert_eq!(motion.events.occurrences.len(), 21);
        for (index, event) in motion.events.occurrences.iter().enumerate() {
            assert!(is_near(event.time, index as f64, 1e-12), "{}", event.time);
            v += 0.5 * x.sin();
            assert!(is_near(event.after[1], v, 1e-9), "{index}: {:?} {v}", event.after);
            x += v;
        }
        assert!(motion.balance.as_ref().is_some_and(|balance| balance.residual < 1e-11));
    }
}

/// `v' = I - v` fires at v = 1 and begins anew every `log(I/(I - 1))`; several neurons do so on their own.
#[test]
fn a_neuron_fires_at_equal_times() {
    for integrator in BOTH {
        let events = ["v > 1: v = 0", "w > 1: w = 0"];
        let neurons = course("v' = I - v; w' = J - w", &events, "I=2 J=3", &[], 20.0);
        let motion = followed(&neurons, integrator);
        for (index, period) in [2.0_f64.ln(), 1.5_f64.ln()].into_iter().enumerate() {
            let own = motion.events.occurrences.iter().filter(|event| event.event == index);
            let own: Vec<f64> = own.map(|event| event.time).collect();
            assert_eq!(own.len(), (20.0 / period) as usize);
            for (count, time) in own.into_iter().enumerate() {
                assert!(is_near(time, period * (count + 1) as f64, 1e-11), "{time}");
            }
        }
        assert!(motion.is_complete() && motion.balance.is_none());
    }
}

/// Andronov's clock: dry friction f swings about f downwards, `L = R - 2 f`, and about -f upwards, where the kick in the
/// middle adds `p^2/2` to the energy, `(R + f)^2 = (L - f)^2 + p^2`. The limit cycle has `R = p^2/(8 f) + f`.
#[test]
fn a_clock_has_the_amplitude_of_its_escapement() {
    let (f, p) = (0.05_f64, 0.3_f64);
    let amplitude = p * p / (8.0 * f) + f;
    for integrator in BOTH {
        for start in [-1.0, -0.25] {
            let events = ["x > 0: x' = sqrt(x'^2 + p^2)"];
            let clock =
                course("x'' + f*sgn(x') + x = 0", &events, "f=0.05 p=0.3", &[("x", start)], 400.0);
            let motion = followed(&TrajectoryRequest { after: 350.0, ..clock }, integrator);
            assert!(motion.is_complete(), "{:?}", motion.reason());
            let [least, greatest] = motion.extremes()[0];
            assert!(is_near(greatest, amplitude, 1e-9), "{greatest} {amplitude}");
            assert!(is_near(least, 2.0 * f - amplitude, 1e-9), "{least}");
            let last: Vec<f64> = times(&motion).into_iter().filter(|time| *time > 380.0).collect();
            let speed = ((amplitude + f).powi(2) - f * f).sqrt();
            let before = (speed * speed - p * p).sqrt();
            // Up to the turn about -f, down for half a period about f, and up to the middle about -f again.
            let expected = (PI / 2.0 - f.atan2(speed)) + PI + (PI / 2.0 + f.atan2(before));
            for pair in last.windows(2) {
                assert!(is_near(pair[1] - pair[0], expected, 1e-9), "{pair:?} {expected}");
            }
        }
    }
}

/// Modes with equations of their own are a coordinate that events set: a thermostat heats towards 3 up to 2 and
/// cools towards 0 down to 1, log(2) each.
#[test]
fn modes_switch_where_their_conditions_come_true() {
    let events = ["u > 2: m = 0", "u < 1: m = 1"];
    let start = [("u", 1.5), ("m", 1.0)];
    for integrator in BOTH {
        let thermostat = course("u' = 3*m - u; m' = 0", &events, "", &start, 10.0);
        let switched = times(&followed(&thermostat, integrator));
        assert!(switched.len() > 10 && is_near(switched[0], 1.5_f64.ln(), 1e-12), "{switched:?}");
        for pair in switched.windows(2) {
            assert!(is_near(pair[1] - pair[0], 2.0_f64.ln(), 1e-12), "{pair:?}");
        }
    }
}

/// New values use the old ones: an exchange; the time and parameters stand in them as well.
#[test]
fn assignments_are_simultaneous() {
    let events = ["when t > 1: x = y; y = x; x' = a*t"];
    let pair = course("x'' = 0; y'' = 0", &events, "a=3", &[("x", 1.0), ("y", 5.0)], 2.0);
    let motion = pair.follow().unwrap();
    assert_eq!(motion.events.occurrences[0].after, [5.0, 1.0, 3.0, 0.0]);
    let state = states(&motion, 2.0);
    assert!(is_near(state[0], 8.0, 1e-14) && is_near(state[1], 1.0, 1e-14), "{state:?}");
    // A coordinate that jumps is seen in its extremes.
    assert_eq!(motion.extremes()[0].map(f64::round), [1.0, 8.0]);
    assert_eq!(motion.extremes()[1], [1.0, 5.0]);
}

/// A start on the guard: towards it is an event at once, away from it there is none, and the next one is not missed.
#[test]
fn a_start_on_the_guard_misses_nothing() {
    for integrator in BOTH {
        for (x, v, expected) in
            [(0.0, -1.0, vec![0.0]), (0.0, 1.0, vec![PI]), (1.0, 0.0, vec![PI / 2.0])]
        {
            let start = [("x", x), ("x'", v)];
            let bounce = course("x'' + x = 0", &["x < 0: x' = -x'"], "", &start, 5.0);
            let own = times(&followed(&bounce, integrator));
            // Each flight between bounces is half a period.
            let mut all = expected.clone();
            while all[all.len() - 1] + PI < 5.0 {
                all.push(all[all.len() - 1] + PI);
            }
            assert_eq!(own.len(), all.len(), "{own:?} {all:?}");
            assert!(own.iter().zip(&all).all(|(one, other)| is_near(*one, *other, 1e-11)));
        }
        // At rest on the guard, it leaves by the force: towards the condition, or away from it.
        let pushed = course("x'' = -1", &["x < 0: x = 1"], "", &[], 1.0);
        assert_eq!(times(&followed(&pushed, integrator)), [0.0]);
        let lifted = course("x'' = 1", &["x < 0: x = 1"], "", &[], 1.0);
        assert!(times(&followed(&lifted, integrator)).is_empty());
    }
}

/// Grazing: a motion that turns before the guard has no event, one that passes it by little has.
#[test]
fn grazing_is_decided_at_the_turning_point() {
    for integrator in BOTH {
        for (threshold, count) in [("1.000000001", 0), ("0.999999999", 3), ("2", 0)] {
            let event = format!("x > {threshold}: y = y + 1");
            let start = [("x", 0.0), ("x'", 1.0)];
            let swing = course("x'' + x = 0; y'' = 0", &[&event], "", &start, 6.0 * PI);
            let motion = followed(&swing, integrator);
            assert_eq!(motion.events.occurrences.len(), count, "{threshold}");
            assert!(is_near(states(&motion, 6.0 * PI)[1], count as f64, 1e-12));
        }
    }
}

/// Events at one time are taken in their order, and it is said where that matters.
#[test]
fn simultaneous_events_are_taken_in_order() {
    for integrator in BOTH {
        for (events, expected, matters) in [
            (["t > 1: x = 2*x", "x > 2: x = x + 1"], 5.0, true),
            (["x > 2: x = x + 1", "t > 1: x = 2*x"], 6.0, true),
            (["t > 1: y = y + 1", "x > 2: x = x + 1"], 3.0, false),
            (["x > 2: x' = -x'", "x > 2: y = y + 1"], 2.0, false),
        ] {
            let start = [("x", 1.0), ("x'", 1.0)];
            let both = course("x'' = 0; y'' = 0", &events, "", &start, 1.5);
            let motion = followed(&both, integrator);
            let occurrences = &motion.events.occurrences;
            assert_eq!(occurrences.len(), 2, "{events:?}: {occurrences:?}");
            assert!(is_near(occurrences[1].after[0], expected, 1e-11), "{occurrences:?}");
            assert_eq!(motion.events.order_matters.is_some(), matters, "{events:?}");
        }
    }
}

/// A reset that jumps over the guard of another event causes it; without an end this is said.
#[test]
fn a_reset_may_cause_another_event() {
    let events = ["t > 1: x = x + 3", "x > 2: x = x - 2"];
    let wrapped = course("x'' = 0", &events, "", &[("x", 0.5)], 2.0).follow().unwrap();
    assert_eq!(states(&wrapped, 2.0), [1.5, 0.0]);
    assert_eq!(wrapped.events.occurrences.len(), 2);
    let events = ["x > 1: x = -2", "x < -1: x = 2"];
    let endless = course("x'' = 0", &events, "", &[("x'", 1.0)], 2.0).follow().unwrap();
    assert_eq!(endless.reason(), PathEnd::EventsAccumulate);
    assert!(is_near(endless.end(), 1.0, 1e-12));
}

/// Walls and events together: a kick drives a ball into a wall, a reset behind a wall is refused.
#[test]
fn events_meet_walls() {
    let start = [("x", 1.0)];
    let wall = Wall::parse("x > 0", &"1/2".parse().unwrap()).unwrap();
    let kicked = course("x'' = 0", &["t > 1: x' = -1"], "", &start, 4.0);
    let motion = kicked.with_walls(wall.clone()).follow().unwrap();
    assert!(is_near(motion.walls.impacts[0].time, 2.0, 1e-12));
    assert!(is_near(states(&motion, 4.0)[0], 1.0, 1e-12));
    // At rest on the floor it is thrown up, and bounces until it rests again.
    let thrown = course("x'' + 2 = 0", &["t > 3: x' = 1"], "", &[], 8.0);
    let motion = thrown.with_walls(wall.clone()).follow().unwrap();
    let rests: Vec<[f64; 2]> =
        motion.walls.rests.iter().map(|rest| [rest.from, rest.until]).collect();
    assert_eq!(rests.len(), 2, "{rests:?}");
    assert!(is_near(rests[0][1], 3.0, 1e-12) && is_near(rests[1][0], 5.0, 1e-9), "{rests:?}");
    let behind = course("x'' = 0", &["t > 1: x = -1"], "", &start, 4.0);
    let error = behind.with_walls(wall).follow().unwrap_err();
    assert!(matches!(error, TrajectoryError::EventBehindWall { .. }), "{error}");
}

/// A sweep and a section have the events that each motion has alone.
#[test]
fn a_sweep_has_the_events_of_each_motion() {
    let events = ["x > d: x' = -e*x'"];
    let mut all = course("x'' + x'/10 + x = cos(t)", &events, "d=1", &[], 60.0);
    all.section = Some(PoincareSection::Events);
    all.after = 20.0;
    let grid: Vec<Vec<f64>> = (5..14).map(|index| vec![0.07 * f64::from(index)]).collect();
    for motion in sweep(&all, &["e".into()], &grid, || ()).expect("motions") {
        let mut alone = all.clone();
        alone.energy = None;
        alone.values.insert("e".into(), motion.values[0]);
        let alone = alone.follow().unwrap();
        assert_eq!(motion.crossings, alone.crossings());
        assert_eq!(motion.events, motion.crossings.len());
        assert!(motion.events > 4);
        assert_eq!(motion.state, states(&alone, 60.0));
        for crossing in &motion.crossings {
            assert!(is_near(crossing.state[0], 1.0, 1e-12) && crossing.state[1] > 0.0);
        }
    }
}

/// A motion of a sweep whose first reset has no value ends at its start, and the others go on.
#[test]
fn a_reset_without_a_value_at_the_start_ends_its_motion_alone() {
    let start = [("x", 0.0), ("x'", -2.0)];
    let all = course("x'' + 9.81 = 0", &["x < 0: x' = -sqrt(a)*x'"], "", &start, 0.3);
    let motions = sweep(&all, &["a".into()], &[vec![-1.0], vec![1.0], vec![0.25]], || ());
    let motions = motions.expect("motions");
    let ends: Vec<_> = motions.iter().map(|motion| (motion.reason, motion.end)).collect();
    let reached = (PathEnd::Reached, 0.3);
    assert_eq!(ends, [(PathEnd::NoReset, 0.0), reached, reached]);
    assert_eq!((motions[0].state.as_slice(), motions[0].events), ([0.0, -2.0].as_slice(), 0));
    assert_eq!(motions[0].extremes, [[0.0, 0.0]]);
    // The flight after the kick: x = 2 t - g t^2/2.
    assert!(is_near(motions[1].state[0], 0.6 - 0.5 * 9.81 * 0.09, 1e-12));
}

/// A block on a belt of the speed v, on a spring: it sticks until the spring pulls with r mu, and slips back about mu with the amplitude
/// `sqrt(a^2 + v^2)`, a = (r - 1) mu, for `2 pi - 2 atan(a/v)`; then it is carried for `2 a/v`.
#[test]
fn static_friction_makes_a_block_stick_and_slip() {
    let (mu, r, v) = (0.3_f64, 1.5_f64, 0.2_f64);
    let a = (r - 1.0) * mu;
    let slip = 2.0 * PI - 2.0 * a.atan2(v);
    for integrator in BOTH {
        let belt =
            course("x'' + mu*sgn(x' - v) + x = 0", &[], "mu=0.3 r=1.5 v=0.2", &[("x'", v)], 60.0);
        let belt = TrajectoryRequest { static_friction: Some("r".parse().unwrap()), ..belt };
        let motion = followed(&belt, integrator);
        assert!(motion.is_complete(), "{:?}", motion.reason());
        let held: Vec<[f64; 2]> = motion.sticking_intervals().collect();
        assert!(is_near(held[0][1], r * mu / v, 1e-9), "{held:?}");
        assert!(held.len() > 6);
        for pair in held[..held.len() - 1].windows(2) {
            assert!(is_near(pair[1][0] - pair[0][1], slip, 1e-8), "{pair:?} {slip}");
            assert!(is_near(pair[1][1] - pair[1][0], 2.0 * a / v, 1e-8), "{pair:?}");
        }
        // On the way the slip is a cosine about mu.
        for step in 1..10 {
            let tau = 0.1 * f64::from(step) * slip;
            let expected = mu + a * tau.cos() + v * tau.sin();
            assert!(is_near(states(&motion, held[0][1] + tau)[0], expected, 1e-9));
        }
        assert!(motion.balance.as_ref().is_some_and(|balance| balance.residual < 1e-9));
        // With one coefficient it is held once, and then swings about mu with the amplitude v.
        let sliding = followed(&TrajectoryRequest { static_friction: None, ..belt }, integrator);
        assert!(is_near(sliding.extremes()[0][1], mu + v, 1e-9), "{:?}", sliding.extremes());
    }
}

/// A block at rest stays until the force is that of static friction; a free swing comes to rest at the first turn
/// within r mu, where the sliding friction alone would not hold it.
#[test]
fn static_friction_holds_more_than_sliding() {
    for integrator in BOTH {
        let with = |equation: &str, ratio: &str, start: &[(&str, f64)]| {
            let course = course(equation, &[], "", start, 40.0);
            let ratio = Some(ratio.parse().unwrap());
            followed(&TrajectoryRequest { static_friction: ratio, ..course }, integrator)
        };
        let pulled = with("x'' + 2*sgn(x') = t/4", "5/4", &[]);
        let held: Vec<[f64; 2]> = pulled.sticking_intervals().collect();
        assert_eq!(held.len(), 1);
        assert!(is_near(held[0][1], 10.0, 1e-9), "{held:?}");
        // From t = 10 on: x'' = t/4 - 2.
        let expected = |time: f64| {
            let (s, t) = (time - 10.0, 2.5 - 2.0);
            t * s * s / 2.0 + s * s * s / 24.0
        };
        assert!(is_near(states(&pulled, 30.0)[0], expected(30.0), 1e-9));
        // The turns are at -0.95, 0.75, -0.55, 0.35, -0.15 and -0.05.
        for (ratio, rest) in
            [("1", -0.05), ("2", -0.15), ("4", 0.35), ("6", -0.55), ("10", -0.95), ("12", 1.15)]
        {
            let swing = with("x'' + 0.1*sgn(x') + x = 0", ratio, &[("x", 1.15)]);
            assert!(
                is_near(states(&swing, 40.0)[0], rest, 1e-9),
                "{ratio}: {:?}",
                states(&swing, 40.0)
            );
            assert!(states(&swing, 40.0)[1] == 0.0);
        }
    }
    let less = course("x'' + sgn(x') + x = 0", &[], "", &[("x", 3.0)], 5.0);
    let less = TrajectoryRequest { static_friction: Some("1/2".parse().unwrap()), ..less };
    let error = less.follow().unwrap_err().to_string();
    assert!(error.contains("must be 1 or more"), "{error}");
    let none = course("x'' + x = 0", &[], "", &[("x", 3.0)], 5.0);
    let none = TrajectoryRequest { static_friction: Some("2".parse().unwrap()), ..none };
    let error = none.follow().unwrap_err().to_string();
    assert!(error.contains("needs a dry friction"), "{error}");
}

/// The exponent of a kicked oscillator on its cycle is that of its damping: the kick moves all motions alike.
#[test]
fn the_exponent_passes_events() {
    let events = ["sin(t) > 0: x' = x' + 1"];
    let kicked = course("x'' + 0.2*x' + x = 0", &events, "", &[("x", 0.3)], 300.0);
    let exponent = kicked.follow().unwrap().lyapunov_exponent().expect("an exponent");
    assert!((exponent.value + 0.1).abs() < 0.01, "{exponent:?}");
}

#[test]
fn bad_events_show_the_place() {
    let states = ["x".into(), "x'".into()];
    for (text, words, place) in [
        ("x > 1", "no `:`", "x > 1"),
        ("x > 1:", "changes nothing", ":"),
        ("x > 1: x = x", "changes nothing", ": x = x"),
        ("x > 1: y = 2", "`y` is not a state", "y"),
        ("x > 1: x'' = 2", "`x''` is not a state", "x''"),
        ("x > 1: x = 2; x = 3", "set twice", "x = 3"),
        ("x > 1: x = 2, x' = 3", "not one value", "x = 2, x' = 3"),
        ("x > 1: x' = 2 x", "2 x", "2 x"),
        ("a > 1: x = 2", "never changes", "a > 1"),
        ("x: x = 2", "no `<`, `>` or `=`", "x"),
        ("0 < x < 1: x = 2", "several conditions", "0 < x < 1"),
        ("x'' > 1: x = 2", "`x''` is not a state", "x'' > 1"),
        ("when x > : x = 2", "side of the inequality is empty", ""),
        ("x = : x = 2", "a side of the condition is empty", "="),
        ("x > 1: x' == 2", "", ""),
    ] {
        let error = StateEvent::parse(text, &states).expect_err(text);
        assert!(error.to_string().contains(words), "{text}: {error}");
        if !place.is_empty() {
            assert_eq!(&text[error.span.clone()], place, "{text}: {error}");
        }
    }
}

/// A guard or a reset without a value is named.
#[test]
fn events_without_a_value_are_refused() {
    let undefined = course("x'' + x = 0", &["log(x) > 1: x' = 0"], "", &[("x", -1.0)], 5.0);
    let error = undefined.follow().unwrap_err().to_string();
    assert!(error.contains("condition of event 1 has no value"), "{error}");
    let root = course("x'' + x = 0", &["x < 0: x' = sqrt(x')"], "", &[("x", 1.0)], 5.0);
    let error = root.follow().unwrap_err().to_string();
    assert!(error.contains("sets `x'` to a value that is not a number"), "{error}");
    let missing = course("x'' + x = 0", &["x < d: x' = e"], "d=1", &[("x", 2.0)], 5.0);
    let error = missing.follow().unwrap_err().to_string();
    assert!(error.contains("no value for `e`"), "{error}");
}

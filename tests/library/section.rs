//! Sections and sweeps of any equation: closed forms, the known cascade of Duffing's two wells, and
//! each motion of a sweep by itself.

use std::f64::consts::{PI, TAU};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use lindstedt::coupled::CoupledEquations;
use lindstedt::event::StateEvent;
use lindstedt::expr::parse_expression;
use lindstedt::system::{Integrator, LANES, PathEnd};
use lindstedt::trajectory::{
    Basins, Fate, PoincareSection, TrajectoryError, TrajectoryRequest, sweep,
};
use lindstedt::{Interrupt, Oscillator, Symbol};

fn course(equation: &str, start: &[(&str, f64)], duration: f64) -> TrajectoryRequest {
    let oscillator = Oscillator::parse(equation).expect("an oscillator");
    let mut course = TrajectoryRequest::of_equation(&oscillator);
    for (name, value) in start {
        course.begin(Symbol::new(name), *value).expect("a state");
    }
    course.duration = duration;
    course
}

fn every(period: &str) -> Option<PoincareSection> {
    Some(PoincareSection::Every(parse_expression(period).expect("a period")))
}

/// `x'' + 2 zeta x' + x = cos(Omega t)` settles on a circle of the section: one point, known in
/// closed form.
#[test]
fn a_linear_motion_settles_on_one_point() {
    let mut course = course("x'' + x'/5 + x = cos(W*t)", &[("x", 1.0)], 300.0);
    course.values = [(Symbol::new("W"), 1.3)].into();
    course.section = every("2*pi/W");
    course.after = 250.0;
    let motion = course.follow().expect("a motion");
    // x = Re X e^(i W t), X = 1/(1 - W^2 + i W/5)
    let (real, imaginary) = (1.0 - 1.3 * 1.3, 1.3 / 5.0);
    let square = real * real + imaginary * imaginary;
    let expected = [real / square, 1.3 * imaginary / square];
    assert!(motion.crossings().len() > 9);
    for crossing in motion.crossings() {
        for (found, expected) in crossing.state.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{crossing:?}, expected {expected:?}");
        }
    }
    let [[least, greatest]] = motion.extremes()[..] else { panic!("one coordinate") };
    assert!((greatest - square.sqrt().recip()).abs() < 1e-9 && (least + greatest).abs() < 1e-9);
}

/// The zeros of the velocity from below are the least displacements: every turn of a linear motion,
/// once.
#[test]
fn a_section_meets_every_zero_from_below() {
    let mut free = course("x'' + 4*x = 0", &[("x", 1.5)], 20.0);
    free.section = Some(PoincareSection::Rising(parse_expression("x'").expect("a velocity")));
    let motion = free.follow().expect("a motion");
    let times: Vec<f64> = motion.crossings().iter().map(|crossing| crossing.time).collect();
    let expected: Vec<f64> =
        (0..).map(|turn| PI / 2.0 + PI * f64::from(turn)).take_while(|time| *time < 20.0).collect();
    assert_eq!(times.len(), expected.len());
    for (time, expected) in times.iter().zip(expected) {
        assert!((time - expected).abs() < 1e-12);
    }
    assert!(motion.crossings().iter().all(|crossing| (crossing.state[0] + 1.5).abs() < 1e-12));
}

/// A section through a turning point is touched from one side, whatever rounding does there; a
/// little inside it is crossed, a little outside it is not met.
#[test]
fn a_section_at_a_turning_point_is_touched_not_crossed() {
    for (section, crossed, touched) in [
        ("x - 1", 0, 6),
        ("1 - x", 0, 6),
        ("x + 1", 0, 6),
        ("-x - 1", 0, 6),
        ("x - 1 + 1e-6", 6, 0),
        ("x - 1 - 1e-6", 0, 0),
        ("x^2 + x'^2 - 2*x", 7, 0),
    ] {
        for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
            let mut free = course("x'' + x = 0", &[("x", 1.0)], 40.0);
            free.section =
                Some(PoincareSection::Rising(parse_expression(section).expect("a section")));
            let motion = free.follow_by(integrator).expect("a motion");
            let found = (motion.crossings().len(), motion.touches().len());
            assert_eq!(
                found,
                (crossed, touched),
                "{section} by {integrator:?}: {:?}",
                motion.touches()
            );
            for (turn, time) in motion.touches().iter().enumerate() {
                let expected = PI
                    * (2.0 * turn as f64
                        + if section.contains("+ 1") || section.starts_with('-') {
                            1.0
                        } else {
                            2.0
                        });
                assert!((time - expected).abs() < 1e-9, "{section}: {time}");
            }
        }
    }
}

/// A motion that dies out goes on crossing the middle, however little.
#[test]
fn small_swings_are_no_touches() {
    let mut damped = course("x'' + x'/2 + x = 0", &[("x", 1.0)], 120.0);
    damped.section = Some(PoincareSection::Rising(parse_expression("x").expect("a section")));
    let motion = damped.follow().expect("a motion");
    let turns = (120.0 * (1.0 - 1.0 / 16.0_f64).sqrt() / TAU).floor() as usize;
    assert!(motion.touches().is_empty() && motion.crossings().len().abs_diff(turns) <= 1);
}

/// The cascade of two wells (D. W. Jordan and P. Smith, *Nonlinear Ordinary Differential
/// Equations*, chapter 13): with `x'' + 0.3 x' - x + x^3 = F cos 1.2 t` the period of the drive is
/// kept at F = 0.20, doubled at 0.28, four times as long at 0.29, five times at 0.37, doubled
/// at 0.65.
#[test]
fn the_two_wells_double_their_period() {
    let mut wells = course("x'' + 3/10*x' - x + x^3 = F*cos(6/5*t)", &[("x", 1.0)], 1500.0);
    wells.section = every("2*pi/(6/5)");
    wells.after = 1300.0;
    let forces = [(0.20, 1), (0.28, 2), (0.29, 4), (0.37, 5), (0.65, 2)];
    let grid: Vec<Vec<f64>> = forces.iter().map(|(force, _)| vec![*force]).collect();
    let motions = sweep(&wells, &[Symbol::new("F")], &grid, || ()).expect("motions");
    for (motion, (force, expected)) in motions.iter().zip(forces) {
        let mut points: Vec<f64> =
            motion.crossings.iter().map(|crossing| crossing.state[0]).collect();
        assert!(points.len() > 30);
        points.sort_by(f64::total_cmp);
        points.dedup_by(|one, other| (*one - *other).abs() < 1e-3);
        assert_eq!(points.len(), expected, "F = {force}: {points:?}");
    }
}

#[test]
fn a_sweep_is_its_motions_one_by_one() {
    let mut driven = course("x'' + c*x' + sin(x) = F*cos(2*t)", &[("x", 0.5)], 30.0);
    driven.values = [(Symbol::new("c"), 0.1)].into();
    driven.section = every("pi");
    let names = [Symbol::new("F"), Symbol::new("x'")];
    let grid: Vec<Vec<f64>> = vec![vec![0.5, 0.0], vec![0.5, 1.0], vec![0.9, 1.0]];
    let motions = sweep(&driven, &names, &grid, || ()).expect("motions");
    for (swept, values) in motions.iter().zip(&grid) {
        let mut alone = driven.clone();
        alone.values.insert(names[0], values[0]);
        alone.begin(names[1], values[1]).expect("a state");
        // A sweep accounts for no energy: works are states, by which steps are chosen too.
        alone.energy = None;
        let alone = alone.follow().expect("a motion");
        assert_eq!(swept.crossings, alone.crossings());
        assert_eq!(swept.state, alone.states_at(30.0).expect("a state"));
        assert_eq!(swept.crossings.len(), (30.0 * 2.0 / TAU) as usize);
    }
    assert_ne!(motions[0].state, motions[1].state);
}

#[test]
fn a_period_that_is_none_is_refused() {
    for (period, name) in
        [("-1", "-1"), ("0*t + 1e-9", "1/1000000000"), ("sqrt(-1 - t^2)", "sqrt(-1 - t^2)")]
    {
        let mut free = course("x'' + x = 0", &[("x", 1.0)], 10.0);
        free.section = every(period);
        match free.follow() {
            Err(TrajectoryError::Period(given, _)) => assert_eq!(given.to_string(), name),
            other => panic!("{period}: {other:?}"),
        }
    }
}

/// The energy of an equation, its potential in closed form, against the work of every other term:
/// in steady state the drive gives what damping takes, `pi c W |X|^2` a period.
#[test]
fn the_energy_of_an_equation_is_accounted_for_term_by_term() {
    let equations = [
        "x'' + c*x' + sin(x) = W*cos(W*t)",
        "x'' + c*x'*abs(x') + x^3 + 100*(x - 1/5)^(3/2)*H(x - 1/5) = 0",
        "x'' + c*sgn(x') + x = W*cos(2*t)",
        "x'' + (1 + c*cos(2*t))*x = 0",
    ];
    for equation in equations {
        let mut course = course(equation, &[("x", 1.0)], 25.0);
        course.values = course.parameters().into_iter().zip([0.1, 0.7]).collect();
        let motion = course.follow().expect("a motion");
        assert!(motion.is_complete(), "{equation}: {:?}", motion.reason());
        let balance = motion.balance.as_ref().expect("an energy");
        assert!(balance.residual < 1e-9, "{equation}: {balance:?}");
        let sum: f64 = balance.works.iter().map(|(_, work)| work).sum();
        assert!(
            (sum - balance.work).abs() < 1e-12 && balance.work.abs() > 1e-3,
            "{equation}: {balance:?}"
        );
    }
    let conservative = course("x'' + x + x^3 = 0", &[("x", 1.0)], 25.0).follow().expect("a motion");
    let balance = conservative.balance.as_ref().expect("an energy");
    assert!(balance.works.is_empty() && (balance.end - 0.75).abs() < 1e-13, "{balance:?}");
    // X = 1/(1 - W^2 + i c W): from settled to settled over one period.
    let (c, w) = (0.2, 1.3);
    let work_until = |duration: f64| {
        let mut driven = course("x'' + c*x' + x = cos(W*t)", &[("x", 0.0)], duration);
        driven.values = [(Symbol::new("c"), c), (Symbol::new("W"), w)].into();
        let balance = driven.follow().expect("a motion").balance.expect("an energy");
        balance.works.into_iter().collect::<std::collections::BTreeMap<String, f64>>()
    };
    let period = TAU / w;
    let (before, after) = (work_until(80.0 * period), work_until(81.0 * period));
    let square = 1.0 / ((1.0 - w * w).powi(2) + c * c * w * w);
    let expected = PI * c * w * square;
    for (name, sign) in [("c*x'", -1.0), ("-cos(W*t)", 1.0)] {
        let work = after[name] - before[name];
        assert!((work - sign * expected).abs() < 1e-9, "{name}: {work}, expected {expected}");
    }
}

/// Once somebody asks to stop, no motion of a sweep is begun: those that were begun before are what
/// they are, and no others come.
#[test]
fn a_sweep_that_is_interrupted_begins_no_other_motion() {
    static STOP: AtomicBool = AtomicBool::new(false);
    static DONE: AtomicUsize = AtomicUsize::new(0);
    const MOTIONS: usize = 2000;
    const ENOUGH: usize = 5;
    let mut course = course("x'' + k*x = 0", &[("x'", 1.0)], 10.0);
    course.interrupt = Interrupt::from_flag(&STOP);
    let grid: Vec<Vec<f64>> = (0..MOTIONS).map(|index| vec![1.0 + index as f64 / 100.0]).collect();
    let count = || {
        if DONE.fetch_add(1, Ordering::Relaxed) + 1 >= ENOUGH {
            STOP.store(true, Ordering::Relaxed);
        }
    };
    let motions = sweep(&course, &["k".into()], &grid, count).expect("motions");
    // Each thread may be at eight, side by side, when it is asked for.
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    assert!((ENOUGH..=ENOUGH + threads * LANES).contains(&motions.len()), "{}", motions.len());
    for motion in motions.iter().filter(|motion| motion.reason == PathEnd::Reached) {
        let frequency = motion.values[0].sqrt();
        assert!((motion.extremes[0][1] - 1.0 / frequency).abs() < 1e-10, "{motion:?}");
        assert!(
            (motion.state[0] - (frequency * 10.0).sin() / frequency).abs() < 1e-10,
            "{motion:?}"
        );
    }
    assert!(motions.windows(2).all(|pair| pair[0].values < pair[1].values));
    // One that has not come to the time from which it counts is none.
    course.after = 5.0;
    assert!(sweep(&course, &["k".into()], &grid, || ()).expect("motions").is_empty());
}

/// Each motion of a sweep is bit for bit the one that is followed by itself: smooth, with corners
/// that move, with pulses, powers and friction.
#[test]
fn a_motion_of_a_sweep_is_that_followed_alone() {
    let rising = |expression: &str| {
        Some(PoincareSection::Rising(parse_expression(expression).expect("an expression")))
    };
    let cases = [
        ("x'' + 2*p*x' + sin(x) = 0", "p", None),
        ("x'' + 2*p*x' + p*sin(p*x) = 0", "p", rising("x - p")),
        ("x'' + x'/10 + p*x + x^3 = cos(p*t)", "p", every("2*pi/p")),
        ("x'' + x + log(2 + p*x) = 0", "p", rising("x'")),
        ("x'' + x + max(p*x - 1, 0)^(3/2) + max(x - p, 0)*x' = 0", "p", rising("x")),
        ("x'' + x + sgn(x')*p = cos(t)", "p", rising("x'")),
        ("x'' + x + abs(x)^p*x' = exp(-((t - 5)/p*20)^2)", "p", None),
        ("x'' + x - p/(x + 3) = 0", "x", rising("x'")),
    ];
    for (equation, name, section) in cases {
        let mut course = course(equation, &[("x", 1.5)], 20.0);
        course.section = section;
        course.values.insert(Symbol::new("p"), 0.3);
        let grid: Vec<Vec<f64>> = [0.3, 0.5, 1.0, 1.25, 2.0].map(|value| vec![value]).into();
        let motions = sweep(&course, &[Symbol::new(name)], &grid, || ()).expect("motions");
        assert_eq!(motions.len(), grid.len());
        for (swept, values) in motions.iter().zip(&grid) {
            let mut alone = course.clone();
            match name {
                "x" => alone.start[0] = values[0],
                _ => _ = alone.values.insert(Symbol::new(name), values[0]),
            }
            alone.energy = None;
            let alone = alone.follow().expect("a motion");
            assert_eq!(swept.reason, alone.reason(), "{equation}");
            assert_eq!(swept.state, alone.states_at(alone.end()).expect("a state"), "{equation}");
            assert_eq!(swept.extremes, alone.extremes(), "{equation}");
            assert_eq!(swept.crossings, alone.crossings(), "{equation}");
            assert_eq!(swept.touches, alone.touches(), "{equation}");
        }
    }
}

/// Starts inside the separatrix of a damped double well settle in their own well: where x'^2/2 - x^2/2 + x^4/4
/// is below zero.
#[test]
fn basins_of_two_wells_hold_the_starts_inside_the_separatrix() {
    let mut wells = course("x'' + x'/5 - x + x^3 = 0", &[], 200.0);
    wells.section = every("1");
    wells.after = 150.0;
    let places =
        (-8..=8).flat_map(|x| (-4..=4).map(move |v| vec![0.19 * f64::from(x), 0.2 * f64::from(v)]));
    let grid: Vec<Vec<f64>> = places.filter(|start| *start != [0.0, 0.0]).collect();
    let motions = sweep(&wells, &["x".into(), "x'".into()], &grid, || ()).expect("motions");
    let basins = Basins::new(&motions);
    assert_eq!(basins.attractors.len(), 2);
    // The mirror image of a start is a start.
    assert!(basins.attractors.iter().all(|own| own.motions == grid.len() / 2), "{basins:?}");
    let mut inside = 0;
    for (start, fate) in grid.iter().zip(&basins.fates) {
        let &[x, v] = start.as_slice() else { panic!("a place and a velocity") };
        let Fate::Settled(index) = *fate else { panic!("{start:?} {fate:?}") };
        let end = &basins.attractors[index].states[0];
        assert!((end[0].abs() - 1.0).abs() < 1e-4 && end[1].abs() < 1e-4, "{end:?}");
        if 0.5 * v * v - 0.5 * x * x + 0.25 * x.powi(4) < 0.0 {
            assert!(end[0] * x > 0.0, "{start:?} {end:?}");
            inside += 1;
        }
    }
    assert!(inside > 40, "{inside}");
}

/// The logistic map as an event: its cycles of one and two states in closed form, and others by their number.
#[test]
fn attractors_have_as_many_states_as_their_cycles() {
    let equations = CoupledEquations::parse("x' = 0; y' = 0").expect("equations");
    let states = ["x".into(), "y".into()];
    let logistic = StateEvent::parse("sin(t) > 0: x = r*x*(1 - x)", &states).expect("an event");
    let mut course = TrajectoryRequest::of_coupled(&equations).with_events(vec![logistic]);
    course.section = Some(PoincareSection::Events);
    (course.duration, course.after) = (TAU * 200.5, TAU * 120.5);
    let grid: Vec<Vec<f64>> = [0.1, 0.35, 0.62, 0.9].map(|x| vec![x]).into();
    for (r, count) in [(2.5, 1), (3.2, 2), (3.5, 4), (3.83, 3)] {
        course.values = [("r".into(), r)].into();
        let motions = sweep(&course, &["x".into()], &grid, || ()).expect("motions");
        let basins = Basins::new(&motions);
        let [attractor] = &basins.attractors[..] else { panic!("r = {r}: {basins:?}") };
        assert_eq!((attractor.states.len(), attractor.motions), (count, 4), "r = {r}");
        let lowest = attractor.states[0][0];
        let expected = match count {
            1 => 1.0 - 1.0 / r,
            2 => (r + 1.0 - ((r - 3.0) * (r + 1.0)).sqrt()) / (2.0 * r),
            _ => continue,
        };
        assert!((lowest - expected).abs() < 1e-9, "r = {r}: {lowest} {expected}");
    }
}

//! Impacts on rigid walls against closed forms: free fall, two walls, collisions of bodies, a shaking
//! table, and the periodic motion of a linear oscillator.

use std::f64::consts::PI;

use lindstedt::Oscillator;
use lindstedt::coupled::CoupledEquations;
use lindstedt::expr::parse_expression;
use lindstedt::mechanics::Mechanism;
use lindstedt::system::{Integrator, PathEnd};
use lindstedt::trajectory::{
    PoincareSection, Trajectory, TrajectoryError, TrajectoryRequest, sweep,
};
use lindstedt::wall::{Wall, WallError};

/// Equations, walls with their coefficients of restitution, and a start.
type Case<'a> = (&'a str, &'a [(&'a str, &'a str)], &'a [(&'a str, f64)]);

/// A problem with walls, each with its coefficient of restitution.
fn course(equations: &str, walls: &[(&str, &str)], values: &str) -> TrajectoryRequest {
    let course = match equations.contains(';') {
        true => TrajectoryRequest::of_coupled(&CoupledEquations::parse(equations).unwrap()),
        false => TrajectoryRequest::of_equation(&Oscillator::parse(equations).unwrap()),
    };
    with_walls(course, walls, values)
}

fn with_walls(
    course: TrajectoryRequest,
    walls: &[(&str, &str)],
    values: &str,
) -> TrajectoryRequest {
    let wall = |(bound, e): &(&str, &str)| Wall::parse(bound, &e.parse().unwrap()).unwrap();
    let mut course = course.with_walls(walls.iter().flat_map(wall).collect());
    for pair in values.split(' ').filter(|pair| !pair.is_empty()) {
        let (name, value) = pair.split_once('=').unwrap();
        course.values.insert(name.into(), value.parse().unwrap());
    }
    course
}

fn begun(mut course: TrajectoryRequest, start: &[(&str, f64)], until: f64) -> TrajectoryRequest {
    for (name, value) in start {
        course.begin((*name).into(), *value).unwrap();
    }
    course.duration = until;
    course
}

fn states(motion: &Trajectory, time: f64) -> Vec<f64> {
    motion.states_at(time).expect("a state")
}

/// A ball that falls from the height h meets the floor at `sqrt(2 h/g)`, then after flights of
/// `2 e^n v/g`, and is at rest after `sqrt(2 h/g) (1 + e)/(1 - e)`; all of `g h` is lost.
#[test]
fn a_ball_comes_to_rest_after_infinitely_many_impacts() {
    for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
        for (g, h, e) in
            [(1.0_f64, 1.0_f64, 0.8_f64), (9.81, 0.3, 0.5), (9.81, 1e-6, 0.9), (1e3, 5.0, 0.0)]
        {
            let course = course("x'' + g = 0", &[("x > 0", "e")], &format!("g={g} e={e}"));
            let fall = (2.0 * h / g).sqrt();
            let rest = fall * (1.0 + e) / (1.0 - e);
            let motion =
                begun(course, &[("x", h)], 2.0 * rest).follow_by(integrator).expect("a motion");
            assert_eq!(motion.reason(), PathEnd::Reached);
            let (v, mut time, mut speed) = (g * fall, fall, g * fall);
            for impact in motion.walls.impacts.iter().take(40) {
                assert!((impact.time - time).abs() < 1e-11 * rest, "{e}: {impact:?}, not {time}");
                assert!((impact.speed - speed).abs() < 1e-9 * v, "{e}: {impact:?}, not {speed}");
                speed *= e;
                time += 2.0 * speed / g;
            }
            let [own] = motion.walls.rests.as_slice() else { panic!("{:?}", motion.walls.rests) };
            assert!((own.from - rest).abs() < 1e-11 * rest, "{e}: {} not {rest}", own.from);
            assert_eq!(own.after_chatter, e > 0.0);
            assert_eq!(states(&motion, 1.5 * rest), [0.0, 0.0]);
            let balance = motion.balance.as_ref().expect("an energy");
            assert!((balance.work + g * h).abs() < 1e-11 * g * h && balance.residual < 1e-11);
            let losses: f64 = motion.walls.impacts.iter().filter_map(|impact| impact.loss).sum();
            assert!((losses - g * h).abs() < 1e-11 * g * h, "{losses}");
        }
    }
}

/// Without loss a body between two walls goes on for ever: `x = d` every second `2 d/v`.
#[test]
fn impacts_without_loss_keep_the_energy() {
    let free = begun(course("x'' = 0", &[("-1 < x < 1", "1")], ""), &[("x'", 3.0)], 100.0);
    let motion = free.follow().unwrap();
    let impacts = &motion.walls.impacts;
    assert_eq!(impacts.len(), 150);
    for (index, impact) in impacts.iter().enumerate() {
        assert!((impact.time - (1.0 + 2.0 * index as f64) / 3.0).abs() < 1e-12);
        assert_eq!((impact.wall, impact.speed, impact.departure), ((index + 1) % 2, 3.0, 3.0));
    }
    // A pendulum over a wall at its lowest point swings with half of its period.
    let pendulum = begun(course("x'' + sin(x) = 0", &[("x > 0", "1")], ""), &[("x", 1.0)], 30.0);
    let motion = pendulum.follow().unwrap();
    let free = begun(course("x'' + sin(x) = 0", &[], ""), &[("x", 1.0)], 30.0).follow().unwrap();
    for step in 1..100 {
        let time = 0.3 * f64::from(step);
        assert!((states(&motion, time)[0] - states(&free, time)[0].abs()).abs() < 1e-11);
    }
    assert!(motion.balance.as_ref().is_some_and(|balance| balance.residual < 1e-12));
}

/// Two bodies: the momentum is kept, and the speeds after are those of Newton's law of impact.
#[test]
fn bodies_that_meet_keep_their_momentum() {
    let equations = "m1*x'' = 0; m2*y'' = 0";
    let both = course(equations, &[("x < y", "e")], "m1=2 m2=5 e=0.3");
    let motion = begun(both, &[("x'", 4.0), ("y", 1.0), ("y'", 1.0)], 2.0).follow().unwrap();
    let [impact] = motion.walls.impacts.as_slice() else { panic!("one impact") };
    assert!((impact.time - 1.0 / 3.0).abs() < 1e-15);
    let (u, v, e, m1, m2) = (4.0, 1.0, 0.3, 2.0, 5.0);
    let after = [
        (m1 * u + m2 * v - m2 * e * (u - v)) / (m1 + m2),
        (m1 * u + m2 * v + m1 * e * (u - v)) / (m1 + m2),
    ];
    let state = states(&motion, 2.0);
    assert!((state[2] - after[0]).abs() < 1e-14 && (state[3] - after[1]).abs() < 1e-14);
    assert_eq!(motion.walls.order_matters, None);
    // With the masses divided out the momentum is not known, and with a matrix that is none it is
    // said.
    let bad = course("x'' + 2*y'' = 0; y'' = 0", &[("x < y", "e")], "e=0.3");
    let error = begun(bad, &[("y", 1.0), ("x'", 1.0)], 2.0).follow().unwrap_err();
    assert!(matches!(error, TrajectoryError::Wall(WallError::WithoutMass(_))), "{error}");
}

/// Newton's cradle: equal balls that touch hand the speed on, one after another.
#[test]
fn a_cradle_hands_the_speed_on() {
    let equations = "x'' = 0; y'' = 0; z'' = 0; u'' = 0";
    let walls = [("y - x > 1", "1"), ("z - y > 1", "1"), ("u - z > 1", "1")];
    let cradle = course(equations, &walls, "");
    let start = [("x", -1.0), ("x'", 2.0), ("y", 1.0), ("z", 2.0), ("u", 3.0)];
    let motion = begun(cradle, &start, 2.0).follow().unwrap();
    let state = states(&motion, 2.0);
    let expected = [0.0, 1.0, 2.0, 6.0, 0.0, 0.0, 0.0, 2.0];
    for (value, expected) in state.iter().zip(expected) {
        assert!((value - expected).abs() < 1e-13, "{state:?}");
    }
    assert_eq!(motion.walls.impacts.len(), 3);
    assert_eq!(motion.walls.order_matters, Some(0.5));
}

/// A body that begins on a table where the table passes the origin rests there for many periods, however its place and
/// speed are rounded.
#[test]
fn a_start_on_a_table_is_a_rest_to_rounding() {
    let speed = 0.012_f64 * 20.0;
    for x in [0.0, 1e-18, -1e-18] {
        for v in [speed, speed.next_up(), speed.next_down()] {
            let mut course = course("x'' + 9.81 = 0", &[("x > 0.012*sin(20*t)", "4/5")], "");
            course.begin("x".into(), x).unwrap();
            course.begin("x'".into(), v).unwrap();
            course.duration = 10.0;
            let motion = course.follow().unwrap();
            assert_eq!(motion.reason(), PathEnd::Reached, "{x:e} {v}");
            assert!(motion.walls.impacts.is_empty());
            let end = motion.states_at(10.0).unwrap();
            assert!((end[0] - 0.012 * 200.0_f64.sin()).abs() < 1e-12, "{end:?}");
        }
    }
}

/// A start a little behind a wall, as slow off it that it never gets before it, is one on the wall: the motion does not
/// fall through, nor is one from nearby said to.
#[test]
fn a_start_a_little_behind_a_wall_is_one_on_it() {
    let table = course("x'' + g = 0", &[("x > Z*sin(w*t)", "1/2")], "g=1 Z=0.4 w=2");
    for speed in [0.8, 0.8 * (1.0 + 1e-12)] {
        let motion = begun(table.clone(), &[("x", -1e-18), ("x'", speed)], 2.0).follow().unwrap();
        assert_eq!(motion.reason(), PathEnd::Reached, "{speed}");
        // It is carried until the table falls faster: sin(2 t) = 1/1.6.
        let release = 0.5 * 0.625_f64.asin();
        assert!((motion.walls.rests[0].until - release).abs() < 1e-9, "{:?}", motion.walls.rests);
        assert_eq!(motion.known_until(), None);
    }
}

/// A ball at rest on a table `Z sin(w t)` is carried until the table falls faster than it does:
/// `sin(w t) = g/(Z w^2)`; then it flies.
#[test]
fn a_table_carries_until_it_falls_faster() {
    for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
        let (g, z, w) = (1.0_f64, 0.4_f64, 2.0_f64);
        let table = course("x'' + g = 0", &[("x > Z*sin(w*t)", "e")], "g=1 Z=0.4 w=2 e=0.5");
        let leaves = (g / (z * w * w)).asin() / w;
        let motion = begun(table, &[("x'", z * w)], 3.0).follow_by(integrator).unwrap();
        let rest = motion.walls.rests[0];
        assert_eq!((rest.from, rest.after_chatter), (0.0, false));
        assert!((rest.until - leaves).abs() < 1e-10, "{} not {leaves}", rest.until);
        assert!((states(&motion, 0.7 * leaves)[0] - z * (w * 0.7 * leaves).sin()).abs() < 1e-13);
        let flight = |time: f64| {
            let t = time - leaves;
            z * (w * leaves).sin() + z * w * (w * leaves).cos() * t - g * t * t / 2.0
        };
        let impact = motion.walls.impacts[0];
        assert!((flight(impact.time) - z * (w * impact.time).sin()).abs() < 1e-10);
        assert!((states(&motion, 0.9 * impact.time)[0] - flight(0.9 * impact.time)).abs() < 1e-10);
        // The relative speed is what the coefficient of restitution is about.
        let table_speed = z * w * (w * impact.time).cos();
        let before = z * w * (w * leaves).cos() - g * (impact.time - leaves) - table_speed;
        assert!((impact.speed + before).abs() < 1e-9);
        assert!((impact.departure - 0.5 * impact.speed).abs() < 1e-15);
        assert!(motion.balance.as_ref().is_some_and(|balance| balance.residual < 1e-9));
    }
}

/// One impact a period of `x'' + x'/10 + x = cos t`, x < 1, e = 0.8 (H. Dankowicz, F. Schilder,
/// *Recipes for Continuation*, SIAM 2013, example 15.2): its speed, from the quadratic of its closed form.
#[test]
fn a_driven_oscillator_settles_on_its_periodic_impacts() {
    let (beta, f, e) = (0.05_f64, 1.0_f64, 0.8_f64);
    let wd = (1.0 - beta * beta).sqrt();
    let decay = (-beta * 2.0 * PI).exp();
    let (sin, cos) = (wd * 2.0 * PI).sin_cos();
    let sigma = (1.0 / decay - cos) / sin;
    let m1 = -beta + wd * sigma;
    let m2 = decay * (-beta * (cos + sigma * sin) + wd * (sigma * cos - sin));
    let g = (1.0 + e) / (m2 - m1);
    let x = f / (2.0 * beta);
    // (1 - g v)^2 + (v (1 - m2 g))^2 = X^2 for the speed v before the impact and e v after it.
    let speed = |v: f64| (1.0 - g * v).powi(2) + (v * (1.0 - m2 * g)).powi(2) - x * x;
    let (mut low, mut high) = (0.0, 100.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if speed(middle) < 0.0 { low = middle } else { high = middle }
    }
    let mut driven = course("x'' + x'/10 + x = cos(t)", &[("x < 1", "4/5")], "");
    driven.section = Some(PoincareSection::Impacts);
    driven.after = 900.0;
    let motion = begun(driven, &[], 1000.0).follow().unwrap();
    assert!(motion.crossings().len() >= 15);
    for pair in motion.crossings().windows(2) {
        assert!((pair[1].time - pair[0].time - 2.0 * PI).abs() < 1e-9);
        assert!((pair[0].state[0] - 1.0).abs() < 1e-12);
        assert!((pair[0].state[1] - low).abs() < 1e-8, "{} not {low}", pair[0].state[1]);
    }
}

/// Both integrators agree on motions of several walls, resting, friction and drive.
#[test]
fn integrators_agree_across_impacts() {
    let cases: [Case; 5] = [
        ("x'' + x'/10 + x + x^3 = 2*cos(t)", &[("-1 < x < 1.2", "0.7")], &[("x", 0.5)]),
        ("x'' + 0.2*sgn(x') + x = cos(1.3*t)", &[("x < 0.5", "0.6")], &[("x", 0.2)]),
        ("x'' + 9.81*sin(x) = 0", &[("x > -0.1", "0.6"), ("x < 1.4", "0.9")], &[("x", 1.0)]),
        ("x'' + 2*x - y = cos(t); y'' + 2*y - x = 0", &[("x < y + 0.3", "0.5")], &[("y", 0.5)]),
        (
            "x'' + 3*x = sin(t); 3*y'' + y' + y - x = 0",
            &[("x < 0.3", "0.5"), ("y > -0.1", "0")],
            &[],
        ),
    ];
    for (equations, walls, start) in cases {
        let asked = begun(course(equations, walls, ""), start, 20.0);
        let [one, other] = [Integrator::Taylor, Integrator::RungeKutta]
            .map(|integrator| asked.clone().follow_by(integrator).expect(equations));
        assert!(one.is_complete() && other.is_complete(), "{equations}: {:?}", one.reason());
        assert!(one.difference(&other) < 1e-7, "{equations}: {}", one.difference(&other));
        assert!(!one.walls.impacts.is_empty(), "{equations}");
        for gap in (0..2000).map(|index| states(&one, 0.01 * f64::from(index))) {
            for wall in &asked.walls {
                let values = asked.rates.states.iter().copied().zip(gap.iter().copied());
                let value = wall.gap.evaluate(&values.collect()).unwrap();
                assert!(value > -1e-9, "{equations}: {} = {value}", wall.gap);
            }
        }
        for balance in one.balance.iter().chain(&other.balance) {
            assert!(balance.residual < 1e-9, "{equations}: {}", balance.residual);
        }
    }
}

/// A mechanism on the axis of its coordinate: a pendulum on a cart hits a wall with the cart, and the
/// momentum along the wall, that of the pendulum's angle, is kept.
#[test]
fn a_mechanism_keeps_the_momentum_along_the_wall() {
    let cart = Mechanism::parse(
        &["x", "p"],
        "M*x'^2/2 + m*(x'^2 + 2*L*x'*p'*cos(p) + L^2*p'^2)/2",
        "m*g*L*(1 - cos(p))",
    )
    .unwrap();
    let course = TrajectoryRequest::of_mechanism(&cart, &cart.equations().unwrap()).unwrap();
    let course = with_walls(course, &[("x < 0.5", "0.6")], "M=2 m=1 L=0.7 g=9.81");
    let motion = begun(course, &[("x'", 1.0), ("p", 0.4)], 3.0).follow().unwrap();
    let impact = motion.walls.impacts[0];
    // The coordinate turns, and what is kept is dT/dp' = m (L x' cos p + L^2 p').
    let near = 1e-9;
    let [before, after] = [-near, near].map(|shift| states(&motion, impact.time + shift));
    let kept = |state: &[f64]| 0.7 * state[2] * state[1].cos() + 0.49 * state[3];
    assert!((after[2] + 0.6 * before[2]).abs() < 1e-7);
    assert!((kept(&before) - kept(&after)).abs() < 1e-7);
    assert!(motion.balance.as_ref().is_some_and(|balance| balance.residual < 1e-10));
}

#[test]
fn a_wall_that_is_violated_at_the_start_is_refused() {
    let behind = course("x'' + x = 0", &[("x < 1", "0.5")], "");
    let error = begun(behind.clone(), &[("x", 2.0)], 1.0).follow().unwrap_err();
    assert!(error.to_string().contains("begins behind a wall"), "{error}");
    // On the wall it begins with an impact, or leaves.
    let hit = begun(behind.clone(), &[("x", 1.0), ("x'", 1.0)], 1.0).follow().unwrap();
    assert_eq!((hit.walls.impacts[0].time, hit.walls.impacts[0].departure), (0.0, 0.5));
    let leaves = begun(behind, &[("x", 1.0), ("x'", -1.0)], 1.0).follow().unwrap();
    assert!(leaves.walls.impacts.is_empty());
    assert!((states(&leaves, 1.0)[0] - (1.0_f64.cos() - 1.0_f64.sin())).abs() < 1e-13);
}

/// A sweep has the motions that each has alone.
#[test]
fn a_sweep_has_the_impacts_of_each_motion() {
    let mut all = course("x'' + x'/10 + x = F*cos(t)", &[("x < 1", "e")], "e=0.8");
    all.duration = 60.0;
    all.section = Some(PoincareSection::Every(parse_expression("2*pi").unwrap()));
    let grid: Vec<Vec<f64>> = (1..20).map(|index| vec![0.1 * f64::from(index)]).collect();
    let swept = sweep(&all, &["F".into()], &grid, || ()).expect("motions");
    for motion in swept {
        let mut alone = all.clone();
        alone.energy = None;
        alone.values.insert("F".into(), motion.values[0]);
        let alone = alone.follow().unwrap();
        assert_eq!(motion.impacts, alone.walls.impacts.len());
        assert_eq!(motion.crossings, alone.crossings());
        assert_eq!(motion.state, states(&alone, 60.0));
    }
}

/// Forces that press only a moment later, chatter beside a wall that bears, corners and stacks: no motion
/// passes a wall, or it says so.
#[test]
fn no_motion_passes_a_wall_unseen() {
    let cases: [Case; 8] = [
        ("x'' + x = sin(t)", &[("x < 0", "0.5")], &[]),
        ("x'' + t = 0", &[("x > 0", "0.5")], &[]),
        ("x'' + t^3 = 0", &[("x > 0", "0.5")], &[]),
        ("x'' + 1 = 0", &[("x > 1 + 0.4*sin(2*t)", "0.3")], &[("x", 1.0), ("x'", 0.8)]),
        ("x'' = 1; y'' = -1", &[("x < 1", "0.5"), ("y > 0", "0.5")], &[]),
        (
            "3*x'' = -1; 2*y'' = -1",
            &[("x > 0", "0.3"), ("y > x", "0.3")],
            &[("x", 1.0), ("y", 2.0)],
        ),
        ("x'' = 0; y'' = -1", &[("y > x", "0"), ("y > -x", "0")], &[("y", 1.0)]),
        ("x'' = 0; y'' + 1 = 0", &[("x^2 + y^2 < 1", "0.5")], &[("x", 0.3)]),
    ];
    for (equations, walls, start) in cases {
        let motion = begun(course(equations, walls, ""), start, 20.0).follow().expect(equations);
        let mut seen = 0;
        for index in 0..=2000 {
            let time = 0.01 * f64::from(index);
            let Some(state) = motion.states_at(time) else { continue };
            let states = motion.course.rates.states.iter().copied().zip(state);
            let values = states.chain([("t".into(), time)]).collect();
            for wall in &motion.course.walls {
                let gap = wall.gap.evaluate(&values).unwrap();
                assert!(gap > -1e-7 || !motion.is_complete(), "{equations}: {gap} at {time}");
            }
            seen += 1;
        }
        assert!(motion.is_complete() || motion.reason() == PathEnd::PassesWall, "{equations}");
        assert!(seen > 50, "{equations}");
    }
}

/// An impact at the start belongs to no account, and the exponent of a motion without loss is zero.
#[test]
fn an_impact_at_the_start_is_before_the_account() {
    let hit = course("x'' + x = 0", &[("x < 1", "0.5")], "");
    let hit = begun(hit, &[("x", 1.0), ("x'", 2.0)], 10.0).follow().unwrap();
    assert!(hit.balance.as_ref().is_some_and(|balance| balance.residual < 1e-12));
    let free = begun(course("x'' = 0", &[("-1 < x < 1", "1")], ""), &[("x'", 3.0)], 16.0);
    let exponent = free.follow().unwrap().lyapunov_exponent().expect("an exponent");
    assert!(exponent.value.abs() < 0.2, "{exponent:?}");
}

/// The largest exponent of a periodic motion with impacts is the logarithm of its larger multiplier over
/// the period.
#[test]
fn the_exponent_of_a_cycle_is_that_of_its_multipliers() {
    // With one impact a period the determinant is e^2 exp(-c T), and the pair is complex: both have
    // half of its logarithm.
    let driven = course("x'' + x'/10 + x = cos(t)", &[("x < 1", "4/5")], "");
    let motion = begun(driven, &[], 1000.0).follow().unwrap();
    let exponent = motion.lyapunov_exponent().expect("an exponent");
    let expected = 0.8_f64.ln() / (2.0 * PI) - 0.05;
    assert!((exponent.value - expected).abs() < 0.01, "{exponent:?} {expected}");
}

/// Between two walls that leave no room there is no motion: it ends where it begins, not behind one of them.
#[test]
fn walls_that_leave_no_room_end_a_motion_where_it_begins() {
    let course = course("x'' + x = 0", &[("x < 1", "1/2"), ("x > 1", "1/2")], "");
    let motion = begun(course, &[("x", 1.0)], 3.0).follow().expect("a motion");
    assert_eq!((motion.reason(), motion.end()), (PathEnd::PassesWall, 0.0));
    assert_eq!(motion.extremes(), [[1.0, 1.0]]);
}

/// A motion may begin where the gap of a round wall is greatest: between x^2 < 1 it is that between -1 < x < 1.
#[test]
fn a_motion_may_begin_where_a_gap_is_greatest() {
    let end = |walls: &[(&str, &str)]| {
        let motion = begun(course("x'' + x/10 = 0", walls, ""), &[("x'", 1.0)], 10.0).follow();
        let motion = motion.expect("a motion");
        assert_eq!((motion.reason(), motion.walls.impacts.len()), (PathEnd::Reached, 2));
        states(&motion, 10.0)
    };
    let (round, straight) = (end(&[("x^2 < 1", "1/2")]), end(&[("-1 < x < 1", "1/2")]));
    for (one, other) in round.iter().zip(&straight) {
        assert!((one - other).abs() < 1e-12, "{round:?} {straight:?}");
    }
}

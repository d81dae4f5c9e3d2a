//! Steady states of coupled equations whose forces jump: against Den Hartog's closed form, the same
//! motions of one coordinate, and simulations that take every jump as an event of their own.

use std::collections::BTreeMap;

use lindstedt::Symbol;
use lindstedt::coupled::CoupledEquations;
use lindstedt::response::bifurcation::BifurcationKind;
use lindstedt::response::{ResponseDiagram, ResponseError, ResponseRequest, SteadyMotion, respond};
use lindstedt::trajectory::TrajectoryRequest;
use lindstedt::verify::Verdict;

fn question(equations: &str, parameter: &str, range: [f64; 2]) -> ResponseRequest {
    ResponseRequest::new(equations, parameter, range, "").expect(equations)
}

fn answer(equations: &str, parameter: &str, range: [f64; 2]) -> ResponseDiagram {
    respond(&question(equations, parameter, range)).expect(equations)
}

fn points(found: &ResponseDiagram) -> impl Iterator<Item = &SteadyMotion> {
    found.branches.iter().flat_map(|branch| &branch.points)
}

/// The motion at an end of the range.
fn at(found: &ResponseDiagram, parameter: f64) -> &SteadyMotion {
    let there: Vec<_> = points(found).filter(|point| point.parameter == parameter).collect();
    let [point] = there[..] else { panic!("{}", there.len()) };
    point
}

/// Coordinates and velocities of two coordinates at the beginning of a motion.
fn start(point: &SteadyMotion) -> Vec<f64> {
    let places = point.coordinates.iter().map(|own| own.start);
    places.chain(point.coordinates.iter().map(|own| own.rate)).collect()
}

/// The states after a time, by the simulation that locates every jump and holds what friction holds.
fn simulated(equations: &str, value: (&str, f64), start: &[f64], duration: f64) -> Vec<f64> {
    let equations = CoupledEquations::parse(equations).expect("equations");
    let course = TrajectoryRequest {
        mass: None,
        walls: vec![],
        events: vec![],
        static_friction: None,
        coordinates: equations.coordinates.clone(),
        equations: vec![],
        rates: equations.rates.clone(),
        energy: None,
        values: BTreeMap::from([(Symbol::new(value.0), value.1)]),
        start: start.to_vec(),
        duration,
        section: None,
        after: 0.0,
        keep_from: f64::NEG_INFINITY,
        tolerance: 1e-14,
        step_limit: 100_000,
        interrupt: Default::default(),
    };
    course.follow().expect("a motion").states_at(duration).expect("a state")
}

/// The largest multiplier of a motion is that of its map, whose derivatives are differences of
/// simulations: the largest eigenvalue by iteration.
fn largest_multiplier(equations: &str, parameter: &str, point: &SteadyMotion) -> f64 {
    const STEP: f64 = 1e-5;
    let (from, period) = (start(point), std::f64::consts::TAU / point.frequency);
    let value = (parameter, point.parameter);
    let columns: Vec<Vec<f64>> = (0..from.len())
        .map(|column| {
            let [above, below] = [STEP, -STEP].map(|step| {
                let mut beside = from.clone();
                beside[column] += step;
                simulated(equations, value, &beside, period)
            });
            above.iter().zip(&below).map(|(one, other)| (one - other) / (2.0 * STEP)).collect()
        })
        .collect();
    // The mean growth of M^k v once only the largest are left.
    let (mut vector, mut grown) = (vec![1.0, 0.7, -0.4, 0.3], 0.0);
    const BEFORE: i32 = 400;
    const TURNS: i32 = 4000;
    for turn in 0..BEFORE + TURNS {
        let next: Vec<f64> =
            (0..4).map(|row| (0..4).map(|k| columns[k][row] * vector[k]).sum()).collect();
        let size = next.iter().map(|value: &f64| value * value).sum::<f64>().sqrt();
        grown += if turn < BEFORE { 0.0 } else { f64::ln(size) };
        vector = next.into_iter().map(|value| value / size).collect();
    }
    (grown / f64::from(TURNS)).exp()
}

/// J. P. Den Hartog, *Trans. ASME* 53 (1931) APM-107: the largest displacement of a motion that does not
/// stop, beside another coordinate that has nothing to do with it.
#[test]
fn an_uncoupled_coordinate_beside_it_changes_nothing() {
    let text = "x'' + x + sgn(x')/5 = cos(w*t); y'' + y'/10 + 2*y = cos(w*t)";
    let found = answer(text, "w", [1.2, 2.0]);
    assert_eq!((found.branches.len(), found.verdict), (1, Verdict::Pass));
    assert!(found.jumps && found.error.is_some_and(|error| error < 1e-8), "{:?}", found.error);
    for point in points(&found).step_by(7) {
        let r = point.parameter;
        let angle = std::f64::consts::PI / r;
        let friction = angle.sin() / (r * (1.0 + angle.cos()));
        let peak = ((1.0 - r * r).powi(-2) - (0.2 * friction).powi(2)).sqrt();
        // The highest point is found by parabolas, beside the jump of the acceleration there.
        assert!((point.peak / peak - 1.0).abs() < 2e-6, "{r}: {} {peak}", point.peak);
        let other = (2.0 - r * r).hypot(r / 10.0).recip();
        assert!((point.coordinates[1].amplitude / other - 1.0).abs() < 1e-9, "{point:?}");
        assert_eq!(point.stable, Some(true));
    }
}

/// Friction between two masses that are driven against each other is that of their distance alone.
#[test]
fn friction_between_two_masses_is_that_of_their_distance() {
    let text = "x'' + x'/20 + x + sgn(x' - y')/4 = cos(w*t)/2; y'' + y'/20 + y - sgn(x' - y')/4 = -cos(w*t)/2";
    let pair = answer(text, "w", [0.4, 1.6]);
    let alone =
        answer("z'' + z'/20 + z + sgn(z')/2 = cos(w*t); y'' + y'/20 + y = 0", "w", [0.4, 1.6]);
    assert!(pair.verdict == Verdict::Pass && alone.verdict == Verdict::Pass);
    for w in [0.4, 1.6] {
        let (one, other) = (at(&pair, w), at(&alone, w));
        let [x, y] = &one.coordinates[..] else { panic!("{one:?}") };
        assert!((x.peak - 0.5 * other.peak).abs() < 1e-9 && (y.peak - x.peak).abs() < 1e-9);
        assert!((x.start - 0.5 * other.start[0]).abs() < 1e-9, "{one:?} {other:?}");
        assert!((one.stuck - other.stuck).abs() < 1e-9, "{} {}", one.stuck, other.stuck);
    }
    assert!(at(&pair, 0.4).stuck > 0.1 && at(&pair, 1.6).stuck == 0.0);
}

/// Motions close after their periods, and multipliers are those of the map, both by simulations that
/// know nothing of the branch.
#[test]
fn motions_and_multipliers_are_those_of_simulation() {
    for (text, range) in [
        // Friction on one of two coupled masses, on both, between them; with sticking.
        (
            "x'' + x'/20 + x + sgn(x')/5 + (x - y)/10 = cos(w*t); y'' + y'/20 + y + (y - x)/10 = 0",
            [1.2, 1.4],
        ),
        (
            "x'' + x'/20 + x + 3*sgn(x')/10 + (x - y)/2 = cos(w*t); y'' + y'/20 + y + sgn(y')/5 + (y - x)/2 = 0",
            [0.6, 0.7],
        ),
        (
            "x'' + x'/20 + x + sgn(x' - y')/5 + (x - y)/10 = cos(w*t); y'' + y'/20 + y - sgn(x' - y')/5 + (y - x)/10 = 0",
            [0.5, 0.6],
        ),
        // A step of the force, one of the stiffness, a slanted one.
        (
            "x'' + x'/20 + x + H(x - 1/2)/2 + (x - y)/10 = cos(w*t); y'' + y'/20 + y + (y - x)/10 = 0",
            [1.3, 1.4],
        ),
        (
            "x'' + x'/20 + x + 5*(x - 1/2)*H(x - 1/2) + (x - y)/10 = cos(w*t); y'' + y'/20 + y + (y - x)/10 = 0",
            [1.1, 1.2],
        ),
        (
            "x'' + x'/20 + x + x^2*H(x' + y/2 - 1/10)/5 + (x - y)/10 = cos(w*t); y'' + y'/20 + y + (y - x)/10 = 0",
            [1.4, 1.5],
        ),
        // A drive that jumps in time.
        (
            "x'' + x'/20 + x + x^3/10 + (x - y)/10 = sgn(sin(w*t)); y'' + y'/20 + y + sgn(y')/50 + (y - x)/10 = 0",
            [1.5, 1.6],
        ),
    ] {
        let found = answer(text, "w", range);
        assert!(found.error.is_some_and(|error| error < 1e-6), "{text}: {:?}", found.error);
        let is_end = |point: &&SteadyMotion| range.contains(&point.parameter);
        let ends: Vec<_> = points(&found).filter(is_end).collect();
        assert!(ends.len() > 1, "{text}");
        for point in ends {
            let w = point.parameter;
            let (from, period) = (start(point), std::f64::consts::TAU / w);
            let end = simulated(text, ("w", w), &from, period);
            let apart = from.iter().zip(&end).map(|(one, other)| (one - other).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-8, "{text}: {from:?} {end:?}");
            let [multiplier, _] = point.multipliers.expect("multipliers");
            let expected = largest_multiplier(text, "w", point);
            assert!((multiplier.norm() - expected).abs() < 1e-3, "{text}: {multiplier} {expected}");
        }
    }
}

/// A mass that sticks forgets where it came from: a multiplier is zero.
#[test]
fn a_motion_of_one_that_sticks_has_a_multiplier_of_zero() {
    let text = "x'' + x + 3*sgn(x')/5 = cos(w*t); y' = -y + x";
    let found = answer(text, "w", [0.45, 0.5]);
    let point = at(&found, 0.5);
    assert!(point.stuck > 0.05, "{point:?}");
    // Of three multipliers that of y is exp(-T), and one of the other two is zero.
    let [one, other] = point.multipliers.expect("multipliers");
    let of_y = (-std::f64::consts::TAU / 0.5).exp();
    assert!(
        (one.norm() - of_y).abs() < 1e-7 || (other.norm() - of_y).abs() < 1e-7,
        "{one} {other}"
    );
    // That of x by the map of one coordinate.
    let alone = ResponseRequest {
        harmonics: Some(24),
        ..question("x'' + x + 3*sgn(x')/5 = cos(w*t)", "w", [0.45, 0.5])
    };
    let alone = respond(&alone).expect("a response");
    let alone = at(&alone, 0.5);
    assert!((alone.stuck - point.stuck).abs() < 1e-6, "{} {}", alone.stuck, point.stuck);
    let largest = alone.multipliers.expect("multipliers")[0].norm();
    assert!((one.norm() - largest.max(of_y)).abs() < 1e-6, "{one} {largest}");
}

/// Two masses on the floor and on each other: where both stick, three frictions hold two velocities.
#[test]
fn more_frictions_than_velocities() {
    let text = "x'' + x'/20 + x + sgn(x')/5 + sgn(x' - y')/10 = cos(w*t); y'' + y'/20 + 2*y + sgn(y')/5 - sgn(x' - y')/10 = 3*cos(w*t)/2";
    let found = answer(text, "w", [0.5, 0.6]);
    assert!(found.error.is_some_and(|error| error < 1e-6), "{:?}", found.error);
    for w in [0.5, 0.6] {
        let point = at(&found, w);
        let end = simulated(text, ("w", w), &start(point), std::f64::consts::TAU / w);
        let apart = start(point)
            .iter()
            .zip(&end)
            .map(|(one, other)| (one - other).abs())
            .fold(0.0, f64::max);
        assert!(apart < 1e-8 && point.stuck > 0.0, "{apart} {point:?}");
    }
}

/// A mass that friction holds all the time beside one that moves: the mover is alone, wherever the other
/// rests.
#[test]
fn a_mass_that_never_moves_is_a_wall() {
    let text = "x'' + x'/20 + x + (x - y)/10 + 3*sgn(x')/10 = cos(w*t); y'' + y'/20 + 2*y + sgn(y') + (y - x)/10 = 0";
    let found = answer(text, "w", [1.3, 1.6]);
    assert_eq!((found.branches.len(), found.verdict), (1, Verdict::Pass), "{:?}", found.elsewhere);
    let alone = answer("x'' + x'/20 + 11*x/10 + 3*sgn(x')/10 = cos(w*t); z' = -z", "w", [1.3, 1.6]);
    for w in [1.3, 1.6] {
        let (point, alone) = (at(&found, w), at(&alone, w));
        assert!(point.stuck == 1.0 && point.coordinates[1].peak < 1e-12, "{point:?}");
        assert!((point.peak - alone.peak).abs() < 1e-9 && point.stable == Some(true));
    }
}

/// Where friction bears all that drives it nothing moves.
#[test]
fn less_force_than_friction_moves_nothing() {
    let text = "x'' + x + sgn(x')/5 + sgn(x' - y')/10 = cos(w*t)/10; y'' + y'/20 + y + sgn(y')/5 - sgn(x' - y')/10 = 0";
    let error = respond(&question(text, "w", [0.5, 1.5])).expect_err("rest");
    assert!(matches!(error, ResponseError::NothingMoves { .. }), "{error}");
}

/// Two masses on belts, one of them driven by the belt alone: the cycle of one coordinate; and two that
/// are coupled close after their period.
#[test]
fn belts_keep_up_cycles_of_two_masses() {
    let belt = "3*sgn(x' - v)*(1 + exp(-10*abs(x' - v))/2)/10";
    let text = format!("x'' + x'/50 + x + {belt} = 0; y'' + y'/20 + 3*y = x/10");
    let found = answer(&text, "v", [0.2, 0.4]);
    let alone = respond(&question(&format!("x'' + x'/50 + x + {belt} = 0"), "v", [0.2, 0.4]))
        .expect("cycles");
    for v in [0.2, 0.4] {
        let stable = |found: &ResponseDiagram| -> SteadyMotion {
            let all =
                points(found).filter(|point| point.parameter == v && point.stable == Some(true));
            all.max_by(|one, other| one.peak.total_cmp(&other.peak)).expect("a cycle").clone()
        };
        let (one, other) = (stable(&found), stable(&alone));
        assert!((one.frequency / other.frequency - 1.0).abs() < 1e-5, "{one:?} {other:?}");
        assert!((one.peak - other.peak).abs() < 1e-4 && one.stuck > 0.1, "{one:?} {other:?}");
    }
    let text =
        format!("x'' + x'/50 + 11*x/10 - y/10 + {belt} = 0; y'' + y'/20 - x/10 + 11*y/10 = 0");
    let found = answer(&text, "v", [0.3, 0.4]);
    let sticking: Vec<_> = points(&found).filter(|point| point.stuck > 0.0).collect();
    assert!(sticking.len() > 10);
    for point in sticking.into_iter().step_by(9) {
        let period = std::f64::consts::TAU / point.frequency;
        let end = simulated(&text, ("v", point.parameter), &start(point), period);
        let apart = start(point)
            .iter()
            .zip(&end)
            .map(|(one, other)| (one - other).abs())
            .fold(0.0, f64::max);
        assert!(apart < 1e-7, "{apart} {point:?}");
    }
}

/// A step of the stiffness, written with `H`, is the one written with `max`.
#[test]
fn a_stop_by_a_step_is_that_by_the_larger() {
    let text = |stop: &str| {
        format!(
            "x'' + 3*(x' - y')/100 + x - y + 100*{stop} = 0; y'' + 3*(2*y' - x')/100 + 2*y - x = cos(w*t)/10"
        )
    };
    let found = answer(&text("(x - 1)*H(x - 1)"), "w", [0.73, 0.77]);
    let doublings = |found: &ResponseDiagram| -> Vec<f64> {
        let kind = BifurcationKind::PeriodDoubling;
        let all = found.bifurcations.iter().filter(|place| place.kind == kind);
        all.map(|place| place.parameter).collect()
    };
    let mut places = doublings(&found);
    places.sort_by(f64::total_cmp);
    // Those of `max`, by shooting in another program.
    for (place, expected) in places.iter().zip([0.738_783_0, 0.755_586_2]) {
        assert!((place - expected).abs() < 2e-6, "{places:?}");
    }
    assert_eq!(places.len(), 2);
}

/// What is not followed says so.
#[test]
fn what_is_not_followed_is_refused() {
    let product = "x'' + x'/20 + x + sgn(x')*sgn(y')/3 = cos(w*t); y'' + y'/20 + y + sgn(y')/5 = 0";
    let error = respond(&question(product, "w", [0.5, 1.5])).expect_err("a product");
    assert_eq!(error, ResponseError::CoupledJump("-sgn(x')*sgn(y')/3".to_owned()));
    // A force that jumps with the place has no next event where it holds the mass on it.
    let place = "x'' + x'/5 + x + sgn(x) = cos(w*t)/2; y'' + y'/20 + y = 0";
    let error = respond(&question(place, "w", [0.8, 0.9])).expect_err("chatter");
    assert_eq!(error, ResponseError::Chatters("x".to_owned()));
}

/// A drive that friction bears moves nothing, and it is said of one coordinate too.
#[test]
fn a_drive_that_friction_bears_moves_nothing() {
    let equation = "x'' + x'/10 + x + sgn(x')/2 = 3*cos(Omega*t)/10";
    let found = respond(&question(equation, "Omega", [0.9, 1.1]));
    assert!(matches!(found, Err(ResponseError::NothingMoves { .. })), "{found:?}");
}

/// A spring of stiffness k in series with dry friction R beside another spring (the element of G. M. Jenkins,
/// *Proc. Phys. Soc.* 79 (1962) 981): the slider z runs at a speed that is larger than that of the mass where
/// the spring bears more than R, so that it slides on `k (x - z) = R`. In a period the drive gives what the
/// damping takes and the loop of force and displacement encloses, 4 R (A - R/k). Integrated here with the
/// force that the slider lets through, in small equal steps, the motion has the same size.
#[test]
fn an_elastic_slider_takes_the_area_of_its_loop() {
    let (stiffness, bound, drive, damping) = (0.5, 0.2, 0.3, 0.02);
    let text = "x'' + x'/50 + x + (x - z)/2 = 0.3*cos(w*t); z' = 5*(sgn((x - z)/2 - 0.2) + sgn((x - z)/2 + 0.2))";
    let found = answer(text, "w", [1.05, 1.15]);
    assert_eq!(found.verdict, Verdict::Pass, "{:?}", found.error);
    assert!(found.branches.len() == 1 && points(&found).all(|point| point.stable == Some(true)));
    for point in points(&found) {
        let x = &point.coordinates[0];
        let given = std::f64::consts::PI * drive * x.amplitude * x.phase.sin();
        let waves = x.harmonics.iter().enumerate();
        let squares = waves.map(|(k, [cosine, sine])| {
            let k = k as f64;
            k * k * (cosine * cosine + sine * sine)
        });
        let damped = damping * std::f64::consts::PI * point.frequency * squares.sum::<f64>();
        let loop_area = 4.0 * bound * (x.peak - bound / stiffness);
        assert!((given / (damped + loop_area) - 1.0).abs() < 1e-4, "{given} {damped} {loop_area}");
    }
    let w = 1.05;
    let (mut x, mut v, mut force, mut peak) = (0.0, 0.0, 0.0_f64, 0.0_f64);
    const STEPS: usize = 20_000;
    let h = std::f64::consts::TAU / w / STEPS as f64;
    for step in 0..120 * STEPS {
        // Velocity in the middle of a step, and the force by its increment, cut off at its bounds.
        let t = h * (step % STEPS) as f64;
        v += h * (drive * (w * t).cos() - damping * v - x - force);
        let moved = h * v;
        x += moved;
        force = (force + stiffness * moved).clamp(-bound, bound);
        if step >= 118 * STEPS {
            peak = peak.max(x.abs());
        }
    }
    let own = at(&found, w).peak;
    assert!((own / peak - 1.0).abs() < 1e-3, "{own} {peak}");
}

//! Periodic impact orbits, held to published numbers, to classical formulas, and to motions that are
//! followed impact by impact from random starts.

use lindstedt::orbits::{
    FoundOrbits, ImpactEquation, ImpactOrbit, OrbitChange, OrbitError, OrbitFamily, OrbitKind,
    OrbitRequest, OrbitStability, OrbitSweep, VaryingParameter, chart_orbits, find_orbits, laws,
    sweep_orbits,
};
use lindstedt::system::{Integrator, PathEnd};
use lindstedt::trajectory::{PreparedTrajectory, TrajectoryRequest};
use lindstedt::wall::Wall;
use lindstedt::{Oscillator, Values, Verdict};

use crate::random::Random;

const BEAM: &str = "x'' + c*x' + k*x = F*cos(w*t)";

fn walls(bounds: &str, restitution: &str) -> Vec<Wall> {
    let restitution = restitution.parse().expect(restitution);
    bounds.split("; ").flat_map(|bound| Wall::parse(bound, &restitution).expect(bound)).collect()
}

fn question(equation: &str, bounds: &str) -> ImpactEquation {
    let oscillator = Oscillator::parse(equation).expect(equation);
    ImpactEquation::new(&oscillator, &walls(bounds, "e")).expect(equation)
}

fn values(text: &str) -> Values {
    text.parse().expect(text)
}

fn found(question: &ImpactEquation, at: &str, impacts: u32, periods: [u32; 2]) -> FoundOrbits {
    let request = OrbitRequest { impacts, periods, ..OrbitRequest::default() };
    find_orbits(question, &values(at), &request).expect(at)
}

fn swept(question: &ImpactEquation, at: &str, name: &str, range: [f64; 2], n: u32) -> OrbitSweep {
    let request = OrbitRequest { periods: [n, n], ..OrbitRequest::default() };
    let vary = VaryingParameter { name: name.into(), range };
    sweep_orbits(question, &values(at), vary, &request).expect(at)
}

fn change(sweep: &OrbitSweep, change: OrbitChange) -> f64 {
    let own = sweep.changes.iter().find(|own| own.change == change);
    own.unwrap_or_else(|| panic!("no {}: {:?}", change.name(), sweep.changes)).parameter
}

/// H. Dankowicz and F. Schilder, Recipes for Continuation (2013), example 15.2: speeds that an
/// event-located simulation gave. The multipliers are those of the product of the flow and of the
/// saltation, with the accelerations before and after the impact from the equation itself.
#[test]
fn a_driven_beam_has_the_known_speeds_and_multipliers() {
    let beam = question(BEAM, "x < d");
    for (force, speed) in [(1.0, 1.695_732_937_6), (0.5, 0.837_016_023_2)] {
        let at = format!("c = 0.1, k = 1, F = {force:?}, w = 1, d = 1, e = 0.8");
        let orbits = found(&beam, &at, 1, [1, 1]);
        let own = &orbits.orbits[0];
        let impact = own.orbit.impacts[0];
        assert!((impact.speed - speed).abs() < 1e-10, "{}", impact.speed);
        // x'' just before and after the impact at x = 1, with x' = v and -0.8 v.
        let acceleration = |velocity: f64| force * impact.phase.cos() - 1.0 - 0.1 * velocity;
        let (before, after) = (acceleration(impact.speed), acceleration(-0.8 * impact.speed));
        let below = (after + 0.8 * before) / impact.speed;
        let saltation = nalgebra::Matrix2::new(-0.8, 0.0, below, -0.8);
        // exp(A T) by squaring.
        let rates = nalgebra::Matrix2::new(0.0, 1.0, -1.0, -0.1);
        let step = rates * (std::f64::consts::TAU / f64::from(1 << 20));
        let small =
            nalgebra::Matrix2::identity() + step + step * step / 2.0 + step * step * step / 6.0;
        let flow = (0..20).fold(small, |power, _| power * power);
        let monodromy = flow * saltation;
        let [first, second] = own.orbit.multipliers;
        assert!(((first + second).re - monodromy.trace()).abs() < 1e-9);
        assert!(((first * second).re - monodromy.determinant()).abs() < 1e-9);
        let verdict = own.verdict.as_ref().expect("a verdict");
        assert!(verdict.multiplier_error.is_some_and(|error| error < 1e-8), "{verdict:?}");
        assert_eq!(verdict.verdict, Verdict::Pass);
    }

    // The free motion F/sqrt((1 - w^2)^2 + c^2 w^2) = 10 F reaches the wall at F = 0.1.
    let sweep = swept(&beam, "c = 0.1, k = 1, w = 1, d = 1, e = 0.8", "F", [0.05, 1.0], 1);
    assert!((change(&sweep, OrbitChange::Grazing) - 0.1).abs() < 1e-13);
}

/// S. W. Shaw and P. J. Holmes (1983): speed and period that a simulation gave.
#[test]
fn an_undamped_oscillator_near_its_stop_has_the_known_orbit() {
    let stop = question("x'' + x = F*cos(w*t)", "x < d");
    let orbits = found(&stop, "F = 1, w = 2.8, d = 0.05, e = 0.8", 1, [1, 1]);
    let stable = orbits.orbits.iter().find(|own| own.orbit.is_admissible()).expect("an orbit");
    assert!((stable.orbit.impacts[0].speed - 0.221_460_380_9).abs() < 1e-10);
    assert!((std::f64::consts::TAU / orbits.frequency - 2.243_994_753).abs() < 1e-9);
}

/// A ball on a table: it keeps step with n periods from Z w^2 = pi n g (1 - e)/(1 + e) on, and until
/// (Z w^2)^2 = (pi n g (1 - e)/(1 + e))^2 + (2 g (1 + e^2)/(1 + e)^2)^2, for the velocity of the
/// table at the impact must be g T (1 - e)/(2 (1 + e)), and an impact that is late by dt leaves the
/// table earlier or later by the acceleration of the table.
#[test]
fn a_ball_on_a_table_keeps_step_between_the_classical_limits() {
    let ball = question("x'' + g = 0", "x > Z*sin(w*t)");
    let (g, w, e) = (9.81, 60.0, 0.5);
    for n in 1..=3 {
        let count = f64::from(n);
        let begin = std::f64::consts::PI * count * g * (1.0 - e) / (1.0 + e);
        let doubling = begin.hypot(2.0 * g * (1.0 + e * e) / (1.0 + e).powi(2));
        let sweep = swept(&ball, "g = 9.81, w = 60, e = 0.5", "Z", [0.0001, 0.02], n);
        let scale = w * w;
        assert!((change(&sweep, OrbitChange::Fold) * scale / begin - 1.0).abs() < 1e-12, "{n}");
        let found = change(&sweep, OrbitChange::PeriodDoubling) * scale;
        assert!((found / doubling - 1.0).abs() < 1e-12, "{n}: {found} {doubling}");
        let speed = g * std::f64::consts::TAU * count / w / (1.0 + e);
        let branches = sweep.branches.iter().flat_map(|branch| &branch.points);
        assert!(branches.into_iter().all(|own| (own.speed / speed - 1.0).abs() < 1e-12));
    }
}

/// Both orbits have the multiplier 1 at the fold, which the quadratic for the speed knows nothing of; at
/// the period doubling one multiplier is -1.
#[test]
fn multipliers_are_one_at_folds_and_minus_one_at_doublings() {
    let beam = question(BEAM, "x < d");
    let (mut folds, mut doublings) = (0, 0);
    for (at, range) in [
        ("c = 0.1, k = 1, w = 2.2, d = 0.3, e = 0.8", [0.01, 3.0]),
        ("c = 0.05, k = 1, w = 2.5, d = 1, e = 0.9", [0.5, 9.0]),
        ("c = 0.3, k = 2, w = 3.5, d = -0.2, e = 0.6", [0.01, 4.0]),
    ] {
        let sweep = swept(&beam, at, "F", range, 1);
        for own in &sweep.changes {
            let at = format!("{at}, F = {:?}", own.parameter * (1.0 + 1e-9));
            let all = found(&beam, &at, 1, [1, 1]);
            let near = |target: f64| {
                let multipliers = all.orbits.iter().flat_map(|own| own.orbit.multipliers);
                multipliers.map(|own| (own - target).norm()).fold(f64::INFINITY, f64::min)
            };
            match own.change {
                OrbitChange::Fold => {
                    folds += 1;
                    assert!(near(1.0) < 1e-3, "{at}: {}", near(1.0));
                }
                OrbitChange::PeriodDoubling => {
                    doublings += 1;
                    assert!(near(-1.0) < 1e-6, "{at}: {}", near(-1.0));
                }
                _ => {}
            }
        }
    }
    assert!(folds > 0 && doublings > 0, "{folds} folds, {doublings} doublings");
}

/// A random linear oscillator and one wall: under-, over- and critically damped, preloaded, without
/// stiffness, from above or below.
fn random(random: &mut Random) -> (ImpactEquation, Values) {
    let mut between = |low: f64, high: f64| low + random.unit() * (high - low);
    let e = between(0.3, 0.9);
    let place = between(-0.6, 1.2);
    let above = between(0.0, 1.0) < 0.5;
    let kind = between(0.0, 5.0);
    let (damping, stiffness, load) = if kind < 1.0 {
        (between(0.0, 0.3), 0.0, if above { 1.0 } else { -1.0 })
    } else if kind < 2.0 {
        (2.0, 1.0, between(-0.3, 0.3))
    } else if kind < 3.0 {
        (between(2.0, 4.0), 1.0, between(-0.3, 0.3))
    } else {
        (between(0.0, 0.6), between(0.3, 2.0), 0.0)
    };
    let [force, frequency, phase] = [between(0.3, 3.0), between(0.6, 3.5), between(0.0, 6.0)];
    let bound = if above { "x < d" } else { "x > d" };
    let equation = if stiffness == 0.0 {
        "x'' + c*x' = F*cos(w*t + p) + P"
    } else {
        "x'' + c*x' + k*x = F*cos(w*t + p) + P"
    };
    let mut at = Values::default();
    let mut numbers = vec![
        ("c", damping),
        ("F", force),
        ("w", frequency),
        ("p", phase),
        ("P", load),
        ("d", place),
        ("e", e),
    ];
    if stiffness != 0.0 {
        numbers.push(("k", stiffness));
    }
    let own = question(equation, bound);
    for (name, value) in numbers {
        if own.parameters().contains(&name.into()) {
            let text = format!("{name} = {value:?}");
            for (name, value) in values(&text).iter() {
                at.insert(name, value.clone()).expect("a new name");
            }
        }
    }
    (own, at)
}

/// A motion between walls, impact by impact.
struct Simulation(PreparedTrajectory);

impl Simulation {
    fn new(own: &ImpactEquation, at: &Values) -> Self {
        let walls = own.walls.iter().map(|wall| wall.wall.clone()).collect();
        let mut course = TrajectoryRequest::of_equation(&own.oscillator).with_walls(walls);
        course.values = at.numbers();
        Self(course.prepared(Integrator::Taylor).expect("a simulation"))
    }

    /// Time, wall and speed of each impact; `None` if the motion ends early.
    fn follow(&self, times: [f64; 2], start: [f64; 2]) -> Option<Vec<(f64, usize, f64)>> {
        let motion = self.0.follow(times, &start).ok()?;
        let impacts = motion.walls.impacts.iter();
        let impacts = impacts.map(|impact| (impact.time, impact.wall, impact.speed)).collect();
        (motion.reason == PathEnd::Reached).then_some(impacts)
    }
}

/// The distance of an impact from the nearest one of an orbit: phase and relative speed.
fn distance(orbit: &ImpactOrbit, frequency: f64, (time, _, speed): (f64, usize, f64)) -> f64 {
    let from = |impact: &lindstedt::orbits::OrbitImpact| {
        let turns = (frequency * time - impact.phase) / std::f64::consts::TAU;
        (turns - turns.round()).abs().max((speed / impact.speed - 1.0).abs())
    };
    orbit.impacts.iter().map(from).fold(f64::INFINITY, f64::min)
}

#[test]
fn simulations_stay_on_stable_orbits_and_settle_on_listed_ones() {
    const COUNT: usize = 300;
    let mut source = Random::new(15);
    let (mut stayed, mut settled, mut passed) = (0, 0, 0);
    for number in 0..COUNT {
        let (own, at) = random(&mut source);
        let request = OrbitRequest { periods: [1, 4], ..OrbitRequest::default() };
        let all = find_orbits(&own, &at, &request).expect("orbits");
        let period = std::f64::consts::TAU / all.frequency;
        let simulation = Simulation::new(&own, &at);
        for judged in all.orbits.iter().filter(|judged| judged.orbit.is_admissible()) {
            let orbit = &judged.orbit;
            let verdict = judged.verdict.as_ref().unwrap_or_else(|| panic!("{number}: {at:?}"));
            assert!(verdict.return_error < 1e-7, "{number}: {at:?} {judged:?}");
            passed += usize::from(verdict.verdict == Verdict::Pass);
            let size = orbit.multipliers.iter().map(|own| own.norm()).fold(0.0, f64::max);
            if orbit.stability != OrbitStability::Stable || size > 0.9 {
                continue;
            }
            // Just after the impact, a little too fast: it comes back to the orbit.
            let impact = orbit.impacts[0];
            let wall = &own.walls[0];
            let place = at.get("d".into()).expect("a place");
            let e = at.get("e".into()).expect("a restitution");
            let velocity = f64::from(wall.side) * e * impact.speed * (1.0 + 1e-5);
            let end = impact.time + f64::from(orbit.periods) * period * 200.0;
            let motion = simulation
                .follow([impact.time, end], [place, velocity])
                .unwrap_or_else(|| panic!("{number}: {at:?} {judged:?}"));
            let last = *motion.last().expect("an impact");
            assert!(distance(orbit, all.frequency, last) < 1e-7, "{number}: {at:?} {judged:?}");
            stayed += 1;
        }
        // A motion from a random start on the allowed side.
        let place = at.get("d".into()).expect("a place");
        let side = f64::from(own.walls[0].side);
        let start = [place + side * (0.01 + 2.0 * source.unit()), 4.0 * source.unit() - 2.0];
        let Some(motion) = simulation.follow([0.0, 400.0 * period], start) else { continue };
        let late: Vec<_> =
            motion.iter().filter(|impact| impact.0 > 380.0 * period).copied().collect();
        let [.., (before, _, slow), (last, wall, speed)] = late[..] else { continue };
        let turns = (last - before) / period;
        let is_settled = (turns - turns.round()).abs() < 1e-9
            && (speed / slow - 1.0).abs() < 1e-9
            && (1.0..4.5).contains(&turns.round());
        if is_settled {
            let listed = all.orbits.iter().filter(|judged| {
                judged.orbit.is_admissible() && f64::from(judged.orbit.periods) == turns.round()
            });
            let nearest = listed
                .map(|judged| distance(&judged.orbit, all.frequency, (last, wall, speed)))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-7, "{number}: {at:?}: {speed} every {turns} is not listed");
            settled += 1;
        }
    }
    assert!(
        stayed > 30 && settled > 30 && passed > 50,
        "{stayed} stayed, {settled} settled, {passed} passed"
    );
}

/// A mass between two stops: the symmetric orbit, its mirror image after half a period, and the
/// multipliers over the whole orbit by the simulation.
#[test]
fn symmetric_orbits_between_two_walls_are_those_of_the_simulation() {
    let stops = question("x'' + c*x' + k*x = F*sin(w*t)", "x > -d; x < d");
    for at in [
        "c = 0.1, k = 1, F = 2, w = 1.5, d = 1, e = 0.7",
        "c = 0.2, k = 1, F = 2, w = 2, d = 1, e = 0.7",
        "c = 0.4, k = 1, F = 3, w = 1.8, d = 0.5, e = 0.6",
    ] {
        let all = found(&stops, at, 1, [1, 1]);
        let symmetric = all
            .orbits
            .iter()
            .find(|own| own.orbit.kind == OrbitKind::Symmetric && own.orbit.is_admissible())
            .unwrap_or_else(|| panic!("{at}: {all:?}"));
        let verdict = symmetric.verdict.as_ref().expect("a verdict");
        assert!(
            verdict.return_error < 1e-9 && verdict.verdict == Verdict::Pass,
            "{at}: {verdict:?}"
        );
        let [one, other] = symmetric.orbit.impacts[..] else { panic!("two impacts") };
        assert!(one.wall != other.wall && one.speed == other.speed);
    }
}

/// Beyond the period doubling a motion of the ball settles on two impacts in two periods, which the
/// search lists; the orbit with one impact is still listed, unstable.
#[test]
fn motions_beyond_a_period_doubling_are_found_by_the_search() {
    let ball = question("x'' + g = 0", "x > Z*sin(w*t)");
    let at = "g = 9.81, Z = 0.0045, w = 60, e = 0.5";
    let [one, two] = [1, 2].map(|count| found(&ball, at, count, [count, count]));
    assert!(one.orbits.iter().all(|own| own.orbit.stability == OrbitStability::Unstable));
    let stable: Vec<_> =
        two.orbits.iter().filter(|own| own.orbit.stability == OrbitStability::Stable).collect();
    assert!(!stable.is_empty(), "{two:?}");
    for own in &two.orbits {
        let verdict = own.verdict.as_ref().expect("a verdict");
        assert!(verdict.return_error < 1e-6, "{own:?}");
    }
    let simulation = Simulation::new(&ball, &values(at));
    let period = std::f64::consts::TAU / 60.0;
    // Just after an impact of the orbit, two per cent too fast: it settles on the orbit.
    let impact = stable[0].orbit.impacts[0];
    let phase = 60.0 * impact.time;
    let velocity = 0.5 * 1.02 * impact.speed + 0.0045 * 60.0 * phase.cos();
    let end = impact.time + 800.0 * period;
    let motion =
        simulation.follow([impact.time, end], [0.0045 * phase.sin(), velocity]).expect("a motion");
    let last = *motion.last().expect("an impact");
    let nearest =
        stable.iter().map(|own| distance(&own.orbit, 60.0, last)).fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-7, "{nearest}: {last:?} {stable:?}");
}

/// The points of a chart are the orbits at their place, and grazing is where the free motion reaches
/// the wall.
#[test]
fn a_chart_counts_the_orbits_at_each_point() {
    let beam = question("x'' + x'/10 + x = F*cos(w*t)", "x < 1");
    let axes = [("w", [0.5, 3.0]), ("F", [0.05, 1.5])]
        .map(|(name, range)| VaryingParameter { name: name.into(), range });
    let request = OrbitRequest { periods: [1, 2], ..OrbitRequest::default() };
    let chart = chart_orbits(&beam, &values("e = 0.8"), axes, 21, &request).expect("a chart");
    let mut seen = 0;
    for (index, point) in chart.points.iter().enumerate().step_by(7) {
        let [w, force] = chart.place(index);
        let at = format!("e = 0.8, w = {w:?}, F = {force:?}");
        let all = found(&beam, &at, 1, [1, 2]);
        for (own, family) in chart.families.iter().enumerate() {
            let of_family = |judged: &&lindstedt::orbits::JudgedImpactOrbit| {
                judged.orbit.periods == family.periods && judged.orbit.is_admissible()
            };
            let orbits: Vec<_> = all.orbits.iter().filter(of_family).collect();
            let stable = orbits.iter().filter(|own| own.orbit.stability == OrbitStability::Stable);
            assert_eq!(usize::from(point.orbits[own]), orbits.len(), "{at}");
            assert_eq!(usize::from(point.stable[own]), stable.count(), "{at}");
            seen += orbits.len();
        }
    }
    assert!(seen > 10, "{seen}");
    let grazing = chart.curves.iter().find(|own| own.change == OrbitChange::Grazing).expect("one");
    for [w, force] in grazing.pieces.iter().flatten() {
        let reach = force / (1.0 - w * w).hypot(w / 10.0);
        assert!((reach - 1.0).abs() < 1e-7, "{reach} at {w}");
    }
    assert_eq!(chart.families[0], OrbitFamily { kind: OrbitKind::OneImpact, wall: 0, periods: 1 });
}

/// The letters, put into numbers, are the numbers.
#[test]
fn laws_in_letters_hold_in_numbers() {
    for (equation, bound, at) in [
        (BEAM, "x < d", "c = 0.1, k = 1, F = 1, w = 1, d = 1, e = 0.8"),
        ("x'' + 3*x' + x = F*cos(w*t) + P", "x > d", "F = 8, w = 2, P = 0.1, d = -1, e = 0.8"),
        (
            "x'' + 2*x' + x = F*sin(w*t) + G*cos(w*t)",
            "x < d",
            "F = 8, G = 1, w = 2, d = 1, e = 0.8",
        ),
        ("x'' + x = F*cos(w*t)", "x < d", "F = 1, w = 2.8, d = 0.05, e = 0.8"),
        ("x'' + g = 0", "x > Z*sin(w*t)", "g = 9.81, Z = 0.008, w = 60, e = 0.5"),
        ("x'' + c*x' + g = 0", "x > Z*sin(w*t)", "c = 0.3, g = 1, Z = 0.1, w = 5, e = 0.8"),
    ] {
        let own = question(equation, bound);
        let laws = &laws(&own).expect(equation)[0];
        let all = found(&own, at, 1, [2, 2]);
        for judged in &all.orbits {
            let orbit = &judged.orbit;
            let mut numbers = values(at).numbers();
            numbers.insert("n".into(), 2.0);
            numbers.insert("v".into(), orbit.impacts[0].speed);
            numbers.insert("phi".into(), orbit.impacts[0].phase);
            for definition in &laws.definitions {
                let value = definition.meaning.evaluate(&numbers).expect("a value");
                numbers.insert(definition.symbol, value);
            }
            for relation in &laws.relations {
                // A root has either sign; what the wave has follows from the phase.
                if relation.name == "multipliers" || relation.words.contains("either sign") {
                    if relation.left.to_string() == "q" {
                        let [u, v] = ["U", "V"]
                            .map(|name| numbers.get(&name.into()).copied().unwrap_or(0.0));
                        let phase = orbit.impacts[0].phase;
                        numbers.insert("q".into(), u * phase.cos() + v * phase.sin());
                    }
                    continue;
                }
                let right = relation.right.evaluate(&numbers).expect("a value");
                match relation.left.as_symbol().filter(|name| !numbers.contains_key(name)) {
                    Some(name) => {
                        numbers.insert(name, right);
                    }
                    None => {
                        let left = relation.left.evaluate(&numbers).expect("a value");
                        let size = left.abs().max(right.abs()).max(1e-3);
                        assert!(
                            (left - right).abs() < 1e-9 * size,
                            "{equation}: {relation:?} {left} {right}"
                        );
                    }
                }
            }
            let [one, other] = orbit.multipliers;
            let (trace, determinant) = ((one + other).re, (one * other).re);
            assert!(
                (numbers[&"tr".into()] - trace).abs() < 1e-9 * trace.abs().max(1.0),
                "{equation}"
            );
            assert!((numbers[&"det".into()] - determinant).abs() < 1e-12, "{equation}");
        }
        assert!(!all.orbits.is_empty(), "{equation}");
    }
}

#[test]
fn what_has_no_orbits_in_closed_form_says_why() {
    let error = |equation: &str, bounds: &str| {
        let oscillator = Oscillator::parse(equation).expect(equation);
        ImpactEquation::new(&oscillator, &walls(bounds, "e")).map(|_| ()).expect_err(equation)
    };
    assert_eq!(error("x'' + x + 0.5*x^3 = cos(t)", "x < 1").term(), Some("0.5*x^3"));
    assert_eq!(error("x'' + x + x*sin(t) = cos(t)", "x < 1").term(), Some("x*sin(t)"));
    assert_eq!(error("x'' + abs(x) + x = cos(t)", "x < 1").term(), Some("abs(x)"));
    for (equation, bounds, words) in [
        ("x'' + x = cos(t) + cos(2*t)", "x < 1", "two frequencies"),
        ("x'' + x = t", "x < 1", "no harmonic wave"),
        ("x'' + x = 1", "x < 1", "nothing drives"),
        ("x'' + x = cos(t)", "x^2 < 1", "not a number times `x`"),
        ("x'' + x = cos(t)", "d < 1", "contains no coordinate"),
        ("x'' + x = cos(t)", "x < 1; x < 2", "do not lie on both sides"),
        ("x'' + x = cos(t)", "x < 1; x < 2; x > 0", "3 walls"),
    ] {
        let error = error(equation, bounds);
        assert!(
            error.to_string().contains(words)
                || words == "no harmonic wave" && error.to_string().contains("not a harmonic wave"),
            "{equation}: {error}"
        );
        assert!(error.help().is_some(), "{equation}: {error}");
    }
    let beam = question(BEAM, "x < d");
    let at = |text: &str| find_orbits(&beam, &values(text), &OrbitRequest::default());
    assert!(matches!(at("c = 1, k = 1, F = 1, w = 1, d = 1, e = 1.5"), Err(OrbitError::Wall(_))));
    assert!(matches!(
        at("c = 1, k = 1, F = 1, w = -1, d = 1, e = 1"),
        Err(OrbitError::Frequency { .. })
    ));
    assert!(matches!(
        at("c = 0, k = 1, F = 1, w = 1, d = 1, e = 0.5"),
        Err(OrbitError::Resonance(_))
    ));
    assert!(
        matches!(at("c = 0, k = 1, F = 1"), Err(OrbitError::Missing(names)) if names.len() == 3)
    );
}

//! Branches of motions with impacts and other events against closed forms: the linear oscillator with a
//! wall, and the one that is kicked.

use std::f64::consts::PI;

use lindstedt::coupled::CoupledEquations;
use lindstedt::event::StateEvent;
use lindstedt::response::bifurcation::BifurcationKind;
use lindstedt::response::continuation::BranchEnd;
use lindstedt::response::{
    Bifurcation, BifurcationCurve, Equations, ResponseDiagram, ResponseError, ResponseRequest,
    SteadyMotion, respond,
};
use lindstedt::verify::Verdict;
use lindstedt::wall::Wall;

fn question(
    equation: &str,
    walls: &[(&str, &str)],
    (parameter, range): (&str, [f64; 2]),
    values: &str,
) -> ResponseRequest {
    let wall = |(bound, e): &(&str, &str)| Wall::parse(bound, &e.parse().unwrap()).unwrap();
    let request = match equation.contains(';') {
        false => ResponseRequest::new(equation, parameter, range, values).expect("a question"),
        true => {
            let first = ResponseRequest::new("x'' + x'/10 + x = cos(t)", parameter, range, values);
            let coupled = CoupledEquations::parse(equation).unwrap();
            ResponseRequest { equations: Equations::Coupled(coupled), ..first.unwrap() }
        }
    };
    ResponseRequest { walls: walls.iter().flat_map(wall).collect(), ..request }
}

/// The points with one impact or event in a period.
fn with_one_impact(found: &ResponseDiagram) -> impl Iterator<Item = &SteadyMotion> {
    let points = found.branches.iter().flat_map(|branch| &branch.points);
    points.filter(|point| point.impacts + point.events == 1)
}

/// The orbits with one impact in n periods of `x'' + c x' + k x = F cos(w t)`, x < d: both roots of the
/// quadratic for the speed v after it, each with trace and determinant of its monodromy matrix.
struct Closed {
    c: f64,
    k: f64,
    w: f64,
    d: f64,
    e: f64,
    periods: f64,
}

impl Closed {
    /// v(F) by the quadratic (d - g v)^2 + (v (1 - m2 g)/w)^2 = X^2, v the speed after the impact over e.
    fn speeds(&self, force: f64) -> Vec<f64> {
        let [g, m2] = self.shape();
        let x = force / ((self.k - self.w * self.w).powi(2) + (self.c * self.w).powi(2)).sqrt();
        let a = g * g + ((1.0 - m2 * g) / self.w).powi(2);
        let b = -2.0 * self.d * g;
        let c = self.d * self.d - x * x;
        let root = b * b - 4.0 * a * c;
        if root < 0.0 {
            return vec![];
        }
        [1.0, -1.0].iter().map(|sign| (-b + sign * root.sqrt()) / (2.0 * a)).collect()
    }

    /// g and m2: displacement and velocity just before the impact of the free part, per unit of speed.
    fn shape(&self) -> [f64; 2] {
        let beta = 0.5 * self.c;
        let wd = (self.k - beta * beta).sqrt();
        let time = 2.0 * PI * self.periods / self.w;
        let (decay, (sin, cos)) = ((-beta * time).exp(), (wd * time).sin_cos());
        let sigma = (1.0 / decay - cos) / sin;
        let m1 = -beta + wd * sigma;
        let m2 = decay * (-beta * (cos + sigma * sin) + wd * (sigma * cos - sin));
        [(1.0 + self.e) / (m2 - m1), m2]
    }
}

/// The request with events in place of its walls.
fn with_events(asked: &ResponseRequest, events: &[&str]) -> ResponseRequest {
    let states = asked.equations.states();
    let events = events.iter().map(|text| StateEvent::parse(text, &states).expect(text));
    ResponseRequest { walls: vec![], events: events.collect(), ..asked.clone() }
}

/// Every point with one impact has the speed of the closed form, and the multipliers e^2 exp(-c T) for
/// their product; and so has every point where the impact is an event.
#[test]
fn one_impact_a_period_has_its_closed_form() {
    let wall = question("x'' + x'/10 + x = F*cos(t)", &[("x < 1", "4/5")], ("F", [0.3, 1.2]), "");
    let closed = Closed { c: 0.1, k: 1.0, w: 1.0, d: 1.0, e: 0.8, periods: 1.0 };
    for asked in [with_events(&wall, &["x > 1: x' = -4/5*x'"]), wall] {
        let found = respond(&asked).expect("a response");
        assert_eq!(found.verdict, Verdict::Pass, "{:?}", found.error);
        let mut compared = 0;
        for point in with_one_impact(&found) {
            // The speed before the impact from the motion itself: one wall, one period.
            let speed = speed_of(&asked, point);
            let near = closed.speeds(point.parameter).into_iter();
            let near = near.map(|v| (v - speed).abs()).fold(f64::INFINITY, f64::min);
            assert!(near < 1e-7 * speed, "F = {}: {speed}", point.parameter);
            let [one, other] = point.multipliers.expect("multipliers");
            let product = (one * other).re;
            let expected = 0.64 * (-0.1 * 2.0 * PI).exp();
            assert!((product - expected).abs() < 1e-7, "F = {}: {product}", point.parameter);
            compared += 1;
        }
        assert!(compared > 10, "{compared}");
    }
}

/// x'' + c x' + x = 0 with a kick p in each period: y = E (y + (0, p)), E = exp(A T).
#[test]
fn kicks_have_their_closed_form() {
    let request = question("x'' + x'/5 + x = 0", &[], ("w", [0.6, 2.3]), "p = 1/2");
    // Both conditions come true at the beginning of a period, the second one to rounding.
    let points = ["sin(w*t) > 0: x' = x' + p", "cos(w*t - pi/2) > 0: x' = x' + p"].map(|event| {
        let mut found = respond(&with_events(&request, &[event])).expect("a response");
        assert_eq!((found.verdict, found.branches.len()), (Verdict::Pass, 1), "{:?}", found.error);
        found.branches.remove(0).points
    });
    for point in points.iter().flatten() {
        let (beta, time) = (0.1_f64, 2.0 * PI / point.parameter);
        let rate = (1.0 - beta * beta).sqrt();
        let (sin, cos) = (rate * time).sin_cos();
        let decay = (-beta * time).exp();
        let [a, b] = [decay * (cos + beta / rate * sin), decay * sin / rate];
        let [c, d] = [-decay * sin / rate, decay * (cos - beta / rate * sin)];
        // (1 - E) y = E (0, p).
        let determinant = (1.0 - a) * (1.0 - d) - b * c;
        let x = 0.5 * ((1.0 - d) * b + b * d) / determinant;
        let v = 0.5 * (c * b + (1.0 - a) * d) / determinant;
        let [own_x, own_v] = point.start;
        let apart = (own_x - x).abs().max((own_v - v).abs());
        assert!(apart < 1e-9, "w = {}: {own_x} {own_v}, {x} {v}", point.parameter);
        let [one, other] = point.multipliers.expect("multipliers");
        assert!(((one * other).re - decay * decay).abs() < 1e-7);
        assert_eq!((point.impacts, point.events, point.stable), (0, 1, Some(true)));
        // The first harmonic of the kicks is a force p w/pi.
        let w = point.parameter;
        let amplitude = 0.5 * w / PI / (1.0 - w * w).hypot(0.2 * w);
        assert!((point.amplitude - amplitude).abs() < 1e-8, "{} {amplitude}", point.amplitude);
    }
    // The kick at the beginning of a period is not counted again at its end.
    let request = question("x'' + x'/5 + x = 0", &[], ("p", [0.5, 1.0]), "");
    let kicked = with_events(&request, &["sin(t) > 0: x' = x' + p"]);
    for periods in [2, 3] {
        let found = respond(&ResponseRequest { periods, ..kicked.clone() }).expect("a response");
        let points = || found.branches.iter().flat_map(|branch| &branch.points);
        assert!(points().count() > 5 && points().all(|point| point.events == periods));
        assert!(points().all(|point| point.amplitude < 1e-7), "{periods}");
        assert_eq!(found.verdict, Verdict::Pass);
    }
}

/// A ball on a table A sin(t), on which it falls once a period: the impact moves through the beginning of the period
/// along the branch, which is one all the same. Its fold is where A = pi (1 - e)/(1 + e) (Guckenheimer and Holmes,
/// section 2.4).
#[test]
fn an_impact_may_fall_on_the_beginning_of_a_period() {
    let request = question("x'' + g = 0", &[("x > A*sin(t)", "4/5")], ("A", [0.34, 1.1]), "g = 1");
    let found = respond(&request).expect("a response");
    let once: Vec<usize> = (0..found.branches.len())
        .filter(|index| found.branches[*index].points[0].impacts == 1)
        .collect();
    assert_eq!(once.len(), 1, "one branch");
    let branch = &found.branches[once[0]];
    assert_eq!(branch.ends, [BranchEnd::Range; 2]);
    for point in &branch.points {
        // The product of both multipliers is e^2.
        let [one, other] = point.multipliers.expect("multipliers");
        assert!(((one * other).re - 0.64).abs() < 1e-9, "A = {}", point.parameter);
        assert!(point.error.is_some_and(|error| error < 1e-7), "A = {}", point.parameter);
    }
    let is_fold =
        |change: &&Bifurcation| change.kind == BifurcationKind::Fold && change.branch == once[0];
    let fold = found.bifurcations.iter().find(is_fold).expect("a fold").parameter;
    assert!((fold - PI / 9.0).abs() < 1e-8, "{fold}");
}

/// A reset that leads away from its condition lets it come true again in the same period: the motion is that of its
/// own series, three resets a period.
#[test]
fn a_reset_can_take_place_again_and_again() {
    let request = question("x'' + x'/5 + x = F*cos(t)", &[], ("F", [0.5, 0.53]), "");
    let found = respond(&with_events(&request, &["x > 1/2: x = 0"])).expect("a response");
    let points = || found.branches.iter().flat_map(|branch| &branch.points);
    assert!(points().count() > 5 && points().all(|point| point.events == 3));
    assert!(points().all(|point| point.error.is_some_and(|error| error < 1e-9)));
}

/// A motion that loses speed at each passage through zero, in either direction: the events are passed, not
/// bounced off, and the motion is that of its own series.
#[test]
fn events_on_both_sides_are_passed() {
    let request = question("x'' + x'/50 + x + x^3 = F*cos(6*t/5)", &[], ("F", [0.2, 0.6]), "");
    let asked = with_events(&request, &["x = 0: x' = 9/10*x'"]);
    let found = respond(&asked).expect("a response");
    assert_eq!(found.verdict, Verdict::Pass, "{:?}", found.error);
    let points = || found.branches.iter().flat_map(|branch| &branch.points);
    assert!(points().count() > 10 && points().all(|point| point.events == 2));
    for point in points() {
        // det M: the loss of both events, each with the speed over that before on its own normal.
        let [one, other] = point.multipliers.expect("multipliers");
        let determinant = 0.9_f64.powi(4) * (-0.02 * 2.0 * PI / 1.2).exp();
        assert!(((one * other).re - determinant).abs() < 1e-7, "F = {}", point.parameter);
    }
}

/// A pendulum clock: a kick p each time the middle is passed upwards. With viscous damping the speed behind
/// the kick is p/(1 - exp(-zeta T)); with dry friction f, where the kick adds p^2 to the square of the speed,
/// the motion turns at p^2/(8 f) + f and f - p^2/(8 f) (Andronov, Vitt and Khaikin, chapter 3).
#[test]
fn clocks_have_their_closed_form() {
    let viscous = question("x'' + 2*zeta*x' + x = 0", &[], ("zeta", [0.02, 0.2]), "p = 1/2");
    let found = respond(&with_events(&viscous, &["x > 0: x' = x' + p"])).expect("a response");
    assert_eq!((found.verdict, found.branches.len()), (Verdict::Pass, 1), "{:?}", found.error);
    for point in &found.branches[0].points {
        let zeta = point.parameter;
        let frequency = (1.0 - zeta * zeta).sqrt();
        let decay = (-zeta * 2.0 * PI / frequency).exp();
        assert!((point.frequency - frequency).abs() < 1e-9, "zeta = {zeta}: {}", point.frequency);
        let [one, other] = point.multipliers.expect("multipliers");
        let apart = (one - decay).norm().min((other - decay).norm());
        assert!(apart < 1e-8 && point.stable == Some(true), "zeta = {zeta}: {one} {other}");
        // The turns after the time in which tan(wd t) = wd/zeta, above and half a period later.
        let turn = frequency.atan2(zeta) / frequency;
        let highest = (-zeta * turn).exp() * 0.5 / (1.0 - decay);
        let peak = 0.5 * highest * (1.0 + decay.sqrt());
        assert!((point.peak - peak).abs() < 1e-8 * peak, "zeta = {zeta}: {} {peak}", point.peak);
    }
    let dry = question("x'' + f*sgn(x') + x = 0", &[], ("f", [0.02, 0.06]), "p = 3/10");
    let found = respond(&with_events(&dry, &["x > 0: x' = sqrt(x'^2 + p^2)"])).expect("a response");
    assert_eq!((found.verdict, found.branches.len()), (Verdict::Pass, 1), "{:?}", found.error);
    for point in &found.branches[0].points {
        let f = point.parameter;
        let peak = 0.09 / (8.0 * f);
        // Friction turns round where the motion does: the highest point is that of a curve with a corner
        // in its second derivative.
        assert!((point.peak - peak).abs() < 1e-6, "f = {f}: {} {peak}", point.peak);
    }
    // Without damping there is no cycle but families of motions.
    let free = question("x'' + w^2*x = 0", &[("x < 1", "1")], ("w", [1.0, 2.0]), "");
    let refused = respond(&free).expect_err("a family");
    assert!(matches!(refused, ResponseError::WallsWithoutLoss), "{refused}");
}

/// An event that sets a state past the condition of another one is not followed, and this is said.
#[test]
fn events_at_once_are_refused() {
    let request = question("x'' + x'/5 + x = F*cos(t)", &[], ("F", [1.0, 2.0]), "");
    let asked = with_events(&request, &["x > 1: x = 3", "x > 2: x' = 0"]);
    let refused = respond(&asked).expect_err("two events at once");
    assert!(matches!(refused, ResponseError::EventsAccumulate), "{refused}");
    // Two on one condition, of which the second would be lost.
    let asked = with_events(&request, &["x > 1/10: x' = -x'", "x > 1/10: x' = x'/2"]);
    let refused = respond(&asked).expect_err("two events at once");
    assert!(matches!(refused, ResponseError::EventsAccumulate), "{refused}");
}

/// The speed before the first impact of a steady motion.
fn speed_of(asked: &ResponseRequest, point: &SteadyMotion) -> f64 {
    use lindstedt::trajectory::TrajectoryRequest;
    let equations = CoupledEquations::new(asked.equations.sides()).unwrap();
    let mut course = TrajectoryRequest::of_coupled(&equations)
        .with_walls(asked.walls.clone())
        .with_events(asked.events.clone());
    course.values = asked.values.numbers();
    course.values.insert(asked.parameter, point.parameter);
    course.start = point.start.to_vec();
    course.duration = 2.0 * PI / point.frequency;
    let motion = course.follow().expect("a motion");
    assert_eq!(motion.walls.impacts.len(), point.impacts);
    match motion.walls.impacts.first() {
        Some(impact) => impact.speed,
        None => motion.events.occurrences[0].before[1],
    }
}

/// The amplitude of the free motion reaches the wall at X = d: there the branch grazes.
#[test]
fn a_branch_grazes_where_the_free_motion_reaches_the_wall() {
    let asked =
        question("x'' + x'/10 + x = F*cos(1.3*t)", &[("x < 1", "4/5")], ("F", [0.1, 1.5]), "");
    let found = respond(&asked).expect("a response");
    let grazing = ((1.0 - 1.69_f64).powi(2) + 0.0169).sqrt();
    let free = found.branches.iter().flat_map(|branch| &branch.points);
    let largest = free.filter(|point| point.impacts == 0).map(|point| point.parameter);
    let largest = largest.fold(0.0, f64::max);
    assert!(found.branches.iter().any(|branch| branch.ends.contains(&BranchEnd::Grazing)));
    assert!(largest <= grazing + 1e-9 && largest > 0.9 * grazing, "{largest} {grazing}");
    for change in &found.bifurcations {
        if change.kind == BifurcationKind::Grazing && change.peak < 1.001 {
            assert!((change.parameter - grazing).abs() < 1e-4, "{change:?} {grazing}");
        }
    }
}

/// Beside the grazing, where the map has a root, the fold of the orbits with one impact is where both roots of their
/// quadratic are one, `X^2 = b^2 d^2/(a^2 + b^2)` at w = 1.
#[test]
fn a_fold_beside_a_grazing_is_that_of_the_closed_form() {
    let asked = question("x'' + x'/10 + x = F*cos(t)", &[("x < 1", "4/5")], ("F", [0.05, 0.3]), "");
    let found = respond(&asked).expect("a response");
    let (e, beta) = (0.8, 0.05_f64);
    let frequency = (1.0 - beta * beta).sqrt();
    let (sine, cosine) = (2.0 * PI * frequency).sin_cos();
    let decay = (-2.0 * PI * beta).exp();
    let (c, s) = (decay * cosine, decay * sine / frequency);
    let determinant = 1.0 - 2.0 * c + decay * decay;
    let a = s * (1.0 + e) / determinant;
    let b = e - (1.0 + e) * (1.0 - c - beta * s) / determinant;
    // The steady wave of the drive F has the amplitude 10 F.
    let fold = 0.1 * b.abs() / a.hypot(b);
    let folds = found.bifurcations.iter().filter(|own| own.kind == BifurcationKind::Fold);
    let folds: Vec<&Bifurcation> = folds.collect();
    let [own] = folds[..] else { panic!("{:?}", found.bifurcations) };
    assert!((own.parameter - fold).abs() < 1e-8, "{own:?} {fold}");
}

/// Branches on both sides of a grazing are found: below it the free motion, above it the fold at which the
/// two motions with an impact meet, the root of the discriminant of their quadratic.
#[test]
fn both_sides_of_a_grazing_are_listed() {
    let asked = question("x'' + x'/10 + x = F*cos(t)", &[("x < 1", "4/5")], ("F", [0.05, 1.2]), "");
    let found = respond(&asked).expect("a response");
    let points = || found.branches.iter().flat_map(|branch| &branch.points);
    let free = points().filter(|point| point.impacts == 0);
    let [least, most] = free.fold([f64::MAX, 0.0], |[least, most], point| {
        [point.parameter.min(least), point.parameter.max(most)]
    });
    assert!(least == 0.05 && most > 0.0999 && most < 0.1 + 1e-9, "{least} {most}");
    let closed = Closed { c: 0.1, k: 1.0, w: 1.0, d: 1.0, e: 0.8, periods: 1.0 };
    let (mut low, mut high) = (0.05, 0.2);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if closed.speeds(middle).is_empty() { low = middle } else { high = middle }
    }
    // Near the grazing, where the range is short enough for it.
    let near = ResponseRequest { range: [0.099, 0.101], ..asked };
    let near = respond(&near).expect("a response");
    let fold = near.bifurcations.iter().find(|change| change.kind == BifurcationKind::Fold);
    let fold = fold.expect("a fold");
    assert!((fold.parameter - low).abs() < 1e-7, "{} {low}", fold.parameter);
}

/// Two bodies that meet: every steady motion agrees with its own series, and its verdict passes.
#[test]
fn coupled_bodies_with_a_wall_between_them_are_followed() {
    let asked = question(
        "x'' + x'/10 + 2*x - y = cos(w*t); y'' + y'/10 + 2*y - x = 0",
        &[("x - y < 0.3", "1/2")],
        ("w", [0.8, 1.2]),
        "",
    );
    let found = respond(&asked).expect("a response");
    assert!(found.error.is_some_and(|error| error < 1e-6), "{:?}", found.error);
    let points = || found.branches.iter().flat_map(|branch| &branch.points);
    assert!(points().any(|point| point.impacts > 0));
    assert!(points().any(|point| point.stable == Some(true)));
}

/// A ball that does not bounce, on a table A sin(t) with A below and above g: it rests on the table, leaves it where
/// A sin(t) = g, and rests again where it lands. Nothing of what was before is left: both multipliers are zero.
#[test]
fn a_ball_that_does_not_bounce_rests_and_leaves() {
    let request = question("x'' + g = 0", &[("x > A*sin(t)", "0")], ("A", [0.9, 1.4]), "g = 1");
    let found = respond(&request).expect("a response");
    assert_eq!(found.branches.len(), 1);
    let branch = &found.branches[0];
    assert_eq!(branch.ends, [BranchEnd::Range; 2]);
    for point in &branch.points {
        let a = point.parameter;
        // The gap at a time after the release, and where it is closed.
        let release = if a > 1.0 { (1.0 / a).asin() } else { 0.0 };
        let gap = |s: f64| 1.0 + a * release.cos() * s - 0.5 * s * s - a * (release + s).sin();
        let grid = (0..=1000).map(|index| 2.0 * PI * f64::from(index) / 1000.0);
        let highest = grid.max_by(|one, other| gap(*one).total_cmp(&gap(*other))).unwrap();
        let (mut low, mut high) = (highest, 2.0 * PI);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if gap(middle) > 0.0 { low = middle } else { high = middle }
        }
        let rests = if a > 1.0 { 1.0 - low / (2.0 * PI) } else { 1.0 };
        if a <= 1.0 || a > 1.05 {
            assert!((point.stuck - rests).abs() < 1e-6, "A = {a}: {} {rests}", point.stuck);
        }
        let [one, other] = point.multipliers.expect("multipliers");
        assert!(one.norm().max(other.norm()) < 1e-6, "A = {a}: {one} {other}");
        assert!(point.error.is_some_and(|error| error < 1e-7), "A = {a}: {:?}", point.error);
    }
    assert_eq!(found.verdict, Verdict::Pass);
    let grazing = found.bifurcations.iter().find(|change| change.kind == BifurcationKind::Grazing);
    assert!((grazing.expect("the first release").parameter - 1.0).abs() < 1e-6);
}

/// The curves of the fold at which both motions with an impact meet, the root of the discriminant of their
/// quadratic, and of the grazing of the free motion, in the amplitude and the frequency of the drive.
#[test]
fn bifurcations_with_walls_are_followed_in_two_parameters() {
    let walls = [("x < 1", "4/5")];
    let asked = question("x'' + x'/10 + x = F*cos(w*t)", &walls, ("F", [0.19, 0.75]), "w = 13/10");
    let along = Some(("w".into(), [1.29, 1.31]));
    let found = respond(&ResponseRequest { along, ..asked }).expect("a response");
    let stiffness = |w: f64| (1.0 - w * w).hypot(0.1 * w);
    let fold = |w: f64| {
        let closed = Closed { c: 0.1, k: 1.0, w, d: 1.0, e: 0.8, periods: 1.0 };
        let [g, m2] = closed.shape();
        let a = g * g + ((1.0 - m2 * g) / w).powi(2);
        stiffness(w) * (1.0 - g * g / a).sqrt()
    };
    for (kind, expected) in [
        (BifurcationKind::Fold, &fold as &dyn Fn(f64) -> f64),
        (BifurcationKind::Grazing, &stiffness),
    ] {
        let of_kind = found.curves.iter().filter(|curve| curve.kind == kind);
        let is_expected = |curve: &&BifurcationCurve| {
            let points = curve.points.iter();
            let apart = points.map(|point| (point.parameter - expected(point.along)).abs());
            curve.points.len() > 5 && apart.fold(0.0, f64::max) < 1e-6
        };
        assert_eq!(of_kind.filter(is_expected).count(), 1, "{kind:?}: {:?}", found.curves);
    }
    assert!(found.stable_motions.is_some());
}

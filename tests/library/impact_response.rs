//! Branches of motions with impacts against closed forms: the linear oscillator with a wall.

use std::f64::consts::PI;

use lindstedt::coupled::CoupledEquations;
use lindstedt::response::bifurcation::BifurcationKind;
use lindstedt::response::continuation::BranchEnd;
use lindstedt::response::{Equations, ResponseDiagram, ResponseRequest, SteadyMotion, respond};
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

/// The points with one impact in a period.
fn with_one_impact(found: &ResponseDiagram) -> impl Iterator<Item = &SteadyMotion> {
    found.branches.iter().flat_map(|branch| &branch.points).filter(|point| point.impacts == 1)
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

/// Every point with one impact has the speed of the closed form, and the multipliers e^2 exp(-c T) for
/// their product.
#[test]
fn one_impact_a_period_has_its_closed_form() {
    let asked = question("x'' + x'/10 + x = F*cos(t)", &[("x < 1", "4/5")], ("F", [0.3, 1.2]), "");
    let found = respond(&asked).expect("a response");
    assert_eq!(found.verdict, Verdict::Pass, "{:?}", found.error);
    let closed = Closed { c: 0.1, k: 1.0, w: 1.0, d: 1.0, e: 0.8, periods: 1.0 };
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

/// The speed before the first impact of a steady motion.
fn speed_of(asked: &ResponseRequest, point: &SteadyMotion) -> f64 {
    use lindstedt::trajectory::TrajectoryRequest;
    let equations = CoupledEquations::new(asked.equations.sides()).unwrap();
    let mut course = TrajectoryRequest::of_coupled(&equations).with_walls(asked.walls.clone());
    course.values = asked.values.numbers();
    course.values.insert(asked.parameter, point.parameter);
    course.start = point.start.to_vec();
    course.duration = 2.0 * PI / point.frequency;
    let motion = course.follow().expect("a motion");
    assert_eq!(motion.walls.impacts.len(), point.impacts);
    motion.walls.impacts[0].speed
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

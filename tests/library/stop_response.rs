//! Steady states of oscillators that meet stops, against the exact motion from piece to piece of a
//! spring in pieces, and shooting with it.

use lindstedt::response::bifurcation::BifurcationKind;
use lindstedt::response::continuation::BranchEnd;
use lindstedt::response::{Branch, ResponseDiagram, ResponseRequest, SteadyMotion, respond};
use lindstedt::verify::Verdict;

fn response(equation: &str, range: [f64; 2], values: &str) -> ResponseDiagram {
    respond(&ResponseRequest::new(equation, "Omega", range, values).expect(equation))
        .expect(equation)
}

/// `x'' + c x' + k x + sum of stiffness (x - at) beyond the stops = F cos(Omega t)`; a stop at a
/// positive place stands on the right, one at a negative place on the left.
struct Pieces<'a> {
    damping: f64,
    drive: f64,
    omega: f64,
    /// Place and stiffness.
    stops: &'a [[f64; 2]],
}

impl Pieces<'_> {
    fn touches(&self, x: f64) -> Vec<bool> {
        self.stops.iter().map(|[at, _]| x * at.signum() > at.abs()).collect()
    }

    /// The state some time after another one, as long as these stops are touched: the closed form
    /// of a linear oscillator.
    fn after(&self, touched: &[bool], [x, v]: [f64; 2], from: f64, time: f64) -> [f64; 2] {
        let active = || self.stops.iter().zip(touched).filter(|(_, touched)| **touched);
        let stiffness = 1.0 + active().map(|([_, k], _)| k).sum::<f64>();
        let offset = active().map(|([at, k], _)| k * at).sum::<f64>() / stiffness;
        let (w, c) = (self.omega, self.damping);
        let detuning = stiffness - w * w;
        let size = self.drive / (detuning * detuning + c * c * w * w);
        let forced = |t: f64| {
            let (sine, cosine) = (w * t).sin_cos();
            [
                offset + size * (detuning * cosine + c * w * sine),
                size * w * (c * w * cosine - detuning * sine),
            ]
        };
        let [x0, v0] = forced(from);
        let (decay, own) = (0.5 * c, (stiffness - 0.25 * c * c).sqrt());
        let (a, b) = (x - x0, (v - v0 + decay * (x - x0)) / own);
        let (sine, cosine) = (own * time).sin_cos();
        let factor = (-decay * time).exp();
        let [x1, v1] = forced(from + time);
        [
            x1 + factor * (a * cosine + b * sine),
            v1 + factor * ((own * b - decay * a) * cosine - (own * a + decay * b) * sine),
        ]
    }

    /// The state a period of the drive after a start at phase zero, and half of peak to peak.
    fn period(&self, start: [f64; 2]) -> ([f64; 2], f64) {
        const STEPS: u32 = 2000;
        let step = std::f64::consts::TAU / self.omega / f64::from(STEPS);
        let mut state = start;
        let (mut low, mut high) = (start[0], start[0]);
        for index in 0..STEPS {
            let (mut time, end) = (step * f64::from(index), step * f64::from(index + 1));
            loop {
                // A hair on, so that what stands on a stop is counted where it goes.
                let touched =
                    self.touches(self.after(&self.touches(state[0]), state, time, 1e-9)[0]);
                let within = |until: f64| {
                    let there = self.after(&touched, state, time, until - time);
                    (there, self.touches(there[0]) == touched)
                };
                let (there, same) = within(end);
                if same || end - time < 1e-9 {
                    state = there;
                    break;
                }
                let (mut before, mut behind) = (time, end);
                for _ in 0..60 {
                    let middle = 0.5 * (before + behind);
                    match within(middle).1 {
                        true => before = middle,
                        false => behind = middle,
                    }
                }
                state = within(behind).0;
                time = behind;
            }
            (low, high) = (low.min(state[0]), high.max(state[0]));
        }
        (state, 0.5 * (high - low))
    }

    /// The point is a motion that comes back, and as large as it says.
    fn holds(&self, point: &SteadyMotion) {
        let (end, peak) = self.period(point.start);
        let missed = (end[0] - point.start[0]).hypot(end[1] - point.start[1]);
        let largest = point.multipliers.map_or(1.0, |multipliers| multipliers[0].norm());
        assert!(missed < 1e-6 * largest.max(1.0), "{} {missed}", point.parameter);
        assert!((point.peak / peak - 1.0).abs() < 2e-3, "{} {peak}", point.parameter);
    }
}

/// A spring that grows stiffer at a stop has no jump, however it is written: one branch, from end to
/// end of the range.
#[test]
fn a_stop_is_no_jump_of_the_force() {
    let one: &[[f64; 2]] = &[[0.5, 20.0]];
    let two: &[[f64; 2]] = &[[1.0, 5.0], [-1.0, 5.0]];
    for (force, drive, stops) in [
        ("20*(x - 0.5)*H(x - 0.5)", 0.3, one),
        ("20*max(x - 0.5, 0)", 0.3, one),
        ("(20*x - 10)*H(2*x - 1)", 0.3, one),
        ("5*(x - 1)*H(x - 1) + 5*(x + 1)*H(-x - 1)", 0.5, two),
    ] {
        let equation = format!("x'' + 0.2*x' + x + {force} = F*cos(Omega*t)");
        let found = response(&equation, [0.5, 3.0], &format!("F = {drive}"));
        assert!(found.by_map && !found.jumps, "{force}");
        assert_eq!(found.verdict, Verdict::Pass, "{force}: {:?} {}", found.error, found.unjudged);
        assert_eq!(found.branches.len(), 1, "{force}");
        let points = &found.branches[0].points;
        let ends = [points.first(), points.last()].map(|point| point.expect("a point").parameter);
        assert_eq!(ends, [0.5, 3.0], "{force}");
        for point in points.iter().filter(|point| point.error.is_some()) {
            let pieces = Pieces { damping: 0.2, drive, omega: point.parameter, stops };
            pieces.holds(point);
        }
    }
}

/// A mass that meets a hard stop, by Hertz's law.
const CONTACT: &str = "x'' + 0.2*x' + x + 1e4*(x - 0.5)^(3/2)*H(x - 0.5) = F*cos(Omega*t)";

/// State and half of peak to peak of the same under F = 0.3 after so many periods, by the classical
/// method of Runge and Kutta.
fn in_contact(omega: f64, start: [f64; 2], periods: u32) -> ([f64; 2], f64) {
    const STEPS: u32 = 4000;
    let step = std::f64::consts::TAU / omega / f64::from(STEPS);
    let rates = |t: f64, [x, v]: [f64; 2]| {
        let force = 1e4 * (x - 0.5).max(0.0).powf(1.5);
        [v, 0.3 * (omega * t).cos() - 0.2 * v - x - force]
    };
    let moved =
        |[x, v]: [f64; 2], by: f64, [x_rate, v_rate]: [f64; 2]| [x + by * x_rate, v + by * v_rate];
    let mut state = start;
    let mut extent = [0.0; 2];
    for _ in 0..periods {
        extent = [state[0]; 2];
        for index in 0..STEPS {
            let t = step * f64::from(index);
            let first = rates(t, state);
            let second = rates(t + 0.5 * step, moved(state, 0.5 * step, first));
            let third = rates(t + 0.5 * step, moved(state, 0.5 * step, second));
            let fourth = rates(t + step, moved(state, step, third));
            for (rate, weight) in [(first, 1.0), (second, 2.0), (third, 2.0), (fourth, 1.0)] {
                state = moved(state, weight * step / 6.0, rate);
            }
            extent = [extent[0].min(state[0]), extent[1].max(state[0])];
        }
    }
    (state, 0.5 * (extent[1] - extent[0]))
}

/// The motion in contact jumps down at one frequency, and has one fold there however the truncated
/// balance waves about it.
#[test]
fn ripple_of_the_balance_is_no_fold() {
    let question =
        ResponseRequest::new(CONTACT, "Omega", [1.4, 1.7], "F = 3/10").expect("a question");
    let found = respond(&ResponseRequest { harmonics: Some(32), ..question }).expect("a response");
    let folds = found.bifurcations.iter().filter(|found| found.kind == BifurcationKind::Fold);
    let folds: Vec<f64> = folds.map(|fold| fold.parameter).collect();
    // A simulation that is led up the branch stays on it at the first of these, and falls from it
    // at the second.
    let (mut state, mut peaks) = ([-0.6, 0.8], vec![]);
    for (omega, periods) in [(1.4, 150), (1.5, 100), (1.55, 100), (1.5605, 150), (1.5625, 400)] {
        let peak;
        (state, peak) = in_contact(omega, state, periods);
        peaks.push(peak);
    }
    assert!(peaks[..4].iter().all(|peak| *peak > 0.7) && peaks[4] < 0.3, "{peaks:?}");
    assert!(folds.len() == 1 && (1.5605..1.5625).contains(&folds[0]), "{folds:?}");
    // The branch waves, and says so.
    assert!(found.ripple.is_some_and(|ripple| ripple.folds > 4 && ripple.range[1] < folds[0]));
}

/// A motion on which simulations settle is followed by as many harmonics as it takes; by fewer it
/// is a branch that is said to be far from the true one, and nothing passes.
#[test]
fn a_motion_that_few_harmonics_do_not_say_is_not_missed() {
    let found = response(CONTACT, [1.3, 1.5], "F = 3/10");
    let (_, peak) = in_contact(1.3, [-0.6, 0.8], 150);
    assert!(peak > 0.6, "{peak}");
    let is_it =
        |point: &SteadyMotion| point.parameter == 1.3 && (point.peak / peak - 1.0).abs() < 5e-3;
    let points = || found.branches.iter().flat_map(|branch| &branch.points);
    assert!(points().any(|point| is_it(point) && point.stable == Some(true)));
    assert!(found.elsewhere.is_empty() && found.verdict == Verdict::Pass, "{:?}", found.elsewhere);
    let by_few = respond(&ResponseRequest { harmonics: Some(8), ..found.question.clone() })
        .expect("a response");
    let points = || by_few.branches.iter().flat_map(|branch| &branch.points);
    assert!(points().all(|point| !is_it(point)));
    let is_near =
        |point: &&SteadyMotion| point.parameter == 1.3 && (point.peak / peak - 1.0).abs() < 0.1;
    let near: Vec<&SteadyMotion> = points().filter(is_near).collect();
    assert!(!near.is_empty() && near.iter().all(|point| point.error.is_some_and(|e| e > 0.02)));
    assert_eq!(by_few.verdict, Verdict::Fail);
}

/// The branch of a stiff contact changes by shooting where it does by harmonic balance of 64 harmonics,
/// whose largest error is a hundredth of the peak, and whose list is pinned here.
#[test]
fn a_stiff_contact_changes_where_harmonic_balance_says() {
    let contact = "x'' + x'/10 + x + g*max(x - 0.5, 0)^1.5 - F*cos(Omega*t) = 0";
    let found = response(contact, [0.5, 2.5], "F = 3/10, g = 1000");
    assert!(found.verdict == Verdict::Pass && found.unjudged == 0, "{:?}", found.error);
    assert!(found.error.is_some_and(|error| error < 1e-4), "{:?}", found.error);
    assert_eq!(found.branches.len(), 1);
    let (fold, doubling) = (BifurcationKind::Fold, BifurcationKind::PeriodDoubling);
    let balanced = [
        (fold, 0.63603, 0.497406),
        (fold, 0.542911, 0.517282),
        (doubling, 0.569118, 0.706413),
        (doubling, 0.597183, 0.724462),
        (fold, 0.623912, 0.747114),
        (fold, 0.623416, 0.745302),
        (doubling, 0.841558, 0.488883),
        (doubling, 0.949831, 0.527011),
        (fold, 1.70031, 1.55261),
        (fold, 1.25951, 0.500463),
    ];
    assert_eq!(found.bifurcations.len(), balanced.len(), "{:?}", found.bifurcations);
    for (one, (kind, parameter, peak)) in found.bifurcations.iter().zip(balanced) {
        assert_eq!(one.kind, kind);
        assert!((one.parameter - parameter).abs() < 3e-5, "{one:?} {parameter}");
        assert!((one.peak / peak - 1.0).abs() < 2e-3, "{one:?} {peak}");
    }
}

/// The discriminant of the impact speed of a motion that meets a rigid wall once a period of the
/// drive, without loss: the free motion in between is that of `x'' + c x' + x = F cos(omega t)`
/// which comes back with the same speed. It is zero at a fold.
///
/// ```text
/// m1 = -b + w s,  m2 = E (-b (C + s S) + w (s C - S)),  s = (1/E - C)/S,  E = exp(-b T),  b = c/2,  C + i S = exp(i w T)
/// (d - g v)^2 + (v (1 - m2 g)/omega)^2 = X^2,   g = 2/(m2 - m1),   X = F/abs(1 - omega^2 + i c omega)
/// ```
fn discriminant_at_rigid_wall([damping, drive, wall]: [f64; 3], omega: f64) -> f64 {
    let period = std::f64::consts::TAU / omega;
    let half = 0.5 * damping;
    let own = (1.0 - half * half).sqrt();
    let decay = (-half * period).exp();
    let (sine, cosine) = (own * period).sin_cos();
    let slope = (1.0 / decay - cosine) / sine;
    let after = -half + own * slope;
    let before = decay * (-half * (cosine + slope * sine) + own * (slope * cosine - sine));
    let gain = 2.0 / (before - after);
    let free = drive / (1.0 - omega * omega).hypot(damping * omega);
    let square = gain * gain + ((1.0 - before * gain) / omega).powi(2);
    wall * wall * gain * gain - square * (wall * wall - free * free)
}

/// A stiff contact tends to a rigid wall as `g^(-2/5)`, the depth of Hertz's contact, and the free
/// motion touches the stop where its amplitude is the gap. One branch passes every touch.
#[test]
fn a_stiff_contact_tends_to_a_rigid_wall_through_every_grazing() {
    let contact = "x'' + x'/10 + x + g*max(x - 0.5, 0)^1.5 - F*cos(Omega*t) = 0";
    let rigid = |[mut low, mut high]: [f64; 2]| {
        let value = |omega: f64| discriminant_at_rigid_wall([0.1, 0.3, 0.5], omega);
        let sign = value(low).signum();
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if value(middle) * sign > 0.0 { low = middle } else { high = middle }
        }
        low
    };
    let followed = |range: [f64; 2], stiffness: &str| {
        let found = response(contact, range, &format!("F = 3/10, g = {stiffness}"));
        assert_eq!(found.verdict, Verdict::Pass, "{stiffness}: {:?}", found.error);
        assert!(found.error.is_some_and(|error| error < 1e-4), "{stiffness}: {:?}", found.error);
        assert!(found.by_map && found.unjudged == 0);
        let range_to_range = |branch: &Branch| branch.ends == [BranchEnd::Range; 2];
        assert!(found.branches.iter().all(range_to_range), "{stiffness}");
        found
    };
    let folds = |found: &ResponseDiagram| -> Vec<f64> {
        let folds = found.bifurcations.iter();
        let folds = folds.filter(|found| found.kind == BifurcationKind::Fold);
        folds.map(|fold| fold.parameter).collect()
    };
    let nearest = |folds: &[f64], to: f64| {
        let apart = folds.iter().map(|fold| (fold - to).abs());
        apart.fold(f64::INFINITY, f64::min)
    };
    // (1 - omega^2)^2 + omega^2/100 = (F/d)^2
    let [first_touch, last_touch] = [-1.0, 1.0].map(|sign: f64| {
        let root = (1.99_f64 * 1.99 - 4.0 * 0.64).sqrt();
        (0.5 * (1.99 + sign * root)).sqrt()
    });
    for (range, bracket, touch) in
        [([0.5, 0.7], [0.5375, 0.538], first_touch), ([1.2, 1.8], [1.775, 1.776], last_touch)]
    {
        let wall = rigid(bracket);
        let apart: Vec<f64> = ["1e6", "1e9"]
            .into_iter()
            .map(|stiffness| {
                let folds = folds(&followed(range, stiffness));
                assert!(nearest(&folds, touch) < 1e-5, "{stiffness}: {folds:?} {touch}");
                nearest(&folds, wall)
            })
            .collect();
        let ratio = apart[0] / apart[1];
        assert!((ratio / 1000_f64.powf(0.4) - 1.0).abs() < 0.05, "{apart:?}");
    }
}

/// Two stiff stops that the symmetric motion touches at once: its branch goes on beyond, and the
/// one of motions that lean to a side is listed once and does not go round for ever.
#[test]
fn a_motion_between_two_stiff_stops_is_followed_past_the_touch_of_both() {
    let stops = "x'' + x'/10 + x + g*max(x - 0.5, 0)^1.5 - g*max(-x - 0.5, 0)^1.5";
    let found = response(&format!("{stops} - 0.3*cos(Omega*t) = 0"), [0.5, 1.1], "g = 1e4");
    assert!(found.verdict == Verdict::Pass && found.unjudged == 0, "{:?}", found.error);
    // Where branches cross the start of a motion is known to fewer digits.
    let points = || found.branches.iter().flat_map(|branch| &branch.points);
    let is_exact = |point: &&SteadyMotion| point.error.is_some_and(|error| error < 1e-5);
    assert!(100 * points().filter(is_exact).count() > 97 * points().count());
    let is_followed = |branch: &Branch| !branch.ends.contains(&BranchEnd::Points);
    assert!(found.branches.iter().all(is_followed));
    // An odd motion has no even harmonics.
    let is_odd = |point: &SteadyMotion| point.harmonics[0][0].abs() < 1e-6;
    let through =
        |branch: &Branch| branch.ends == [BranchEnd::Range; 2] && branch.points.iter().all(is_odd);
    assert!(found.branches.iter().any(through));
}

/// A branch that could not be followed past the touch of a very stiff stop is met again from beyond,
/// and is one: the two have been listed side by side, and a simulation from the last point of the first,
/// at the touch, went elsewhere.
#[test]
fn a_branch_that_is_lost_at_a_touch_and_met_from_beyond_is_listed_once() {
    let equation = "x'' + 0.1*x' + x + 1e6*max(x - 1, 0) = cos(Omega*t)";
    let found = response(equation, [0.3, 2.5], "");
    assert_eq!((found.branches.len(), found.unjudged), (1, 0));
    assert!(found.verdict == Verdict::Pass, "{:?}", found.error);
    // From one end of the range to the other, through all folds.
    let points = &found.branches[0].points;
    let [low, high] = [0, points.len() - 1].map(|index| points[index].parameter);
    assert_eq!([low.min(high), low.max(high)], [0.3, 2.5]);
    // det M = exp(-c T), whatever the motion touches.
    for point in points {
        let [one, other] = point.multipliers.expect("multipliers");
        let exact = (-0.1 * std::f64::consts::TAU / point.parameter).exp();
        assert!(((one * other).re / exact - 1.0).abs() < 1e-6, "{point:?}");
    }
}

//! Steady states against a linear spring with a dashpot, beside the closed form of each piece of the motion.

use std::f64::consts::TAU;

use lindstedt::response::{ResponseRequest, SteadyMotion, respond};

const DAMPING: f64 = 0.1;
const DRIVE: f64 = 0.5;
/// Stiffness and damping of the contact at x > 1.
const CONTACT: [f64; 2] = [1e4, 20.0];

/// The state of `x'' + c x' + k x = F cos(w t) + k0` some time after another one.
fn after([k, c, offset]: [f64; 3], w: f64, [x, v]: [f64; 2], [from, to]: [f64; 2]) -> [f64; 2] {
    let detuning = k - w * w;
    let size = DRIVE / (detuning * detuning + c * c * w * w);
    let forced = |t: f64| {
        let (s, c0) = (w * t).sin_cos();
        [offset / k + size * (detuning * c0 + c * w * s), size * w * (c * w * c0 - detuning * s)]
    };
    let ([x0, v0], [x1, v1]) = (forced(from), forced(to));
    let (b, free) = (0.5 * c, (k - 0.25 * c * c).sqrt());
    let (s, c0) = (free * (to - from)).sin_cos();
    let decay = (-b * (to - from)).exp();
    let (y, z) = (x - x0, v - v0);
    [
        x1 + decay * (y * (c0 + b * s / free) + z * s / free),
        v1 + decay * (z * (c0 - b * s / free) - k * y * s / free),
    ]
}

/// The first time after `from` at which a function of it changes its sign, to rounding.
fn first_zero(f: impl Fn(f64) -> f64, [from, to]: [f64; 2], cells: usize) -> Option<f64> {
    let time = |cell: usize| from + (to - from) * cell as f64 / cells as f64;
    let changes = |cell: &usize| f(time(*cell)) * f(time(cell + 1)) < 0.0;
    let cell = (1..cells).find(changes)?;
    let (mut low, mut high) = (time(cell), time(cell + 1));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(low) * f(middle) <= 0.0 { high = middle } else { low = middle }
    }
    Some(0.5 * (low + high))
}

/// The state a period later by the closed forms of flight and contact, one after the other, and whether there was a
/// contact.
fn period_later(point: &SteadyMotion, pulls: bool) -> ([f64; 2], bool) {
    let [stiffness, damping] = CONTACT;
    let w = point.parameter;
    let flight = [1.0, DAMPING, 0.0];
    let contact = [1.0 + stiffness, DAMPING + damping, stiffness];
    let (mut state, mut time, end) = (point.start, 0.0, TAU / w);
    let mut touches = false;
    for _ in 0..8 {
        let free = |t: f64| after(flight, w, state, [time, t]);
        let Some(touch) = first_zero(|t| free(t)[0] - 1.0, [time, end], 20_000) else {
            return (free(end), touches);
        };
        let (at_touch, begin) = ([1.0, free(touch)[1]], touch);
        touches = true;
        let held = |t: f64| after(contact, w, at_touch, [begin, t]);
        let gap = |t: f64| 1.0 - held(t)[0];
        let force = |t: f64| stiffness * (held(t)[0] - 1.0) + damping * held(t)[1];
        let reach = [begin, begin + 0.05];
        let leaves = match pulls {
            true => first_zero(gap, reach, 20_000),
            false => first_zero(force, reach, 20_000),
        };
        let leaves = leaves.expect("an end of the contact");
        (state, time) = (held(leaves), leaves);
        if !pulls {
            // Without pull it flies on behind the wall's place, back through it.
            let out = |t: f64| after(flight, w, state, [time, t]);
            let back = first_zero(|t| out(t)[0] - 1.0, [time, time + 0.2], 2_000);
            let back = back.expect("the place of the wall");
            (state, time) = ([1.0, out(back)[1]], back);
        }
    }
    (state, touches)
}

/// The peak and the start of every motion close by the closed forms; the motion without contact, that with a short one
/// and that with a long one are there side by side.
#[test]
fn motions_against_a_dashpot_are_those_of_their_closed_form() {
    let forces = [
        (true, "(10000*(x - 1) + 20*x')*H(x - 1)"),
        (false, "max(10000*(x - 1) + 20*x', 0)*H(x - 1)"),
    ];
    for (pulls, force) in forces {
        let equation = format!("x'' + x'/10 + x + {force} = cos(w*t)/2");
        let request = ResponseRequest::new(&equation, "w", [1.0, 1.3], "").expect("a request");
        let found = respond(&request).expect("a response");
        assert!(found.error.is_some_and(|error| error < 1e-6), "{:?}", found.error);
        let points = || found.branches.iter().flat_map(|branch| &branch.points);
        // The scan for the touch sees no shorter contact.
        let is_seen = |point: &&SteadyMotion| (point.peak - 1.0).abs() > 1e-4;
        for point in points().step_by(4).filter(is_seen) {
            let (end, touches) = period_later(point, pulls);
            assert!(touches || point.peak <= 1.0, "{pulls} {point:?}");
            let (one, other) = (end[0] - point.start[0], end[1] - point.start[1]);
            // A disturbance grows by the multiplier.
            let growth = point.multipliers.map_or(1.0, |all| all[0].norm().max(1.0));
            assert!(one.hypot(other) < 1e-8 * growth, "{pulls} {point:?}: {end:?}");
        }
        let near = |w: f64| points().filter(move |point| (point.parameter - w).abs() < 0.006);
        let at = 1.28;
        let free = ((1.0_f64 - at * at).powi(2) + 0.01 * at * at).sqrt().recip() * DRIVE;
        assert!(near(at).any(|point| (point.peak / free - 1.0).abs() < 0.02), "{pulls}");
        assert!(near(at).any(|point| point.peak > 1.2 && point.stable == Some(true)), "{pulls}");
        assert!(near(at).any(|point| point.stable == Some(false)), "{pulls}");
        // Beyond the wall the free motion is faster than w = 1, whatever the dashpot.
        let backbone = found.backbone.iter().flatten();
        let beyond = backbone.filter(|point| point.amplitude > 1.02).collect::<Vec<_>>();
        assert!(beyond.iter().all(|point| point.parameter > 1.05), "{pulls}: {beyond:?}");
    }
}

/// Beside the grazing the branch without contact turns into that with a short one: a fold, no crossing, and both
/// branches by the closed forms.
#[test]
fn a_narrow_range_has_the_branch_with_a_short_contact() {
    use lindstedt::response::bifurcation::BifurcationKind;
    let equation = "x'' + x'/10 + x + (10000*(x - 1) + 20*x')*H(x - 1) = cos(w*t)/2";
    let request = ResponseRequest::new(equation, "w", [1.2, 1.25], "").expect("a request");
    let found = respond(&request).expect("a response");
    assert_eq!(found.branches.len(), 2);
    let [fold] = &found.bifurcations[..] else { panic!("{:?}", found.bifurcations) };
    // The free motion touches the wall where (1 - w^2)^2 + w^2/100 = 1/4.
    let square = 0.5 * (1.99 + (1.99_f64.powi(2) - 3.0).sqrt());
    assert!(fold.kind == BifurcationKind::Fold, "{fold:?}");
    assert!((fold.parameter - square.sqrt()).abs() < 1e-7, "{fold:?}");
    let branch = &found.branches[fold.branch];
    let ends = [branch.points.first(), branch.points.last()].map(|point| point.expect("a point"));
    let [low, high] = [ends[0].peak.min(ends[1].peak), ends[0].peak.max(ends[1].peak)];
    assert!(ends.iter().all(|point| point.parameter == 1.25) && low < 0.9 && high > 1.01);
    let seen = branch.points.iter().filter(|point| point.peak > 1.0 + 1e-4);
    for point in seen.clone() {
        let (end, touches) = period_later(point, true);
        let (one, other) = (end[0] - point.start[0], end[1] - point.start[1]);
        let growth = point.multipliers.map_or(1.0, |all| all[0].norm());
        assert!(touches && one.hypot(other) < 1e-8 * growth, "{point:?}: {end:?}");
        assert_eq!(point.stable, Some(false));
    }
    assert!(seen.count() > 10);
}

/// The law of multibody programs, which damps with a step of the depth: every point of its branches is judged, and
/// those of a step that is over at once are those of a dashpot that does not pull.
#[test]
fn a_dashpot_that_comes_in_by_a_step_is_judged_throughout() {
    let of = |step: &str, range| {
        let force = format!("max(10000*max(x - 1, 0) + 20*x'*{step}, 0)");
        let equation = format!("x'' + x'/10 + x + {force}*H(x - 1) = cos(w*t)/2");
        let request = ResponseRequest::new(&equation, "w", range, "").expect("a request");
        respond(&request).expect("a response")
    };
    let part = "min(max(x - 1, 0)*10000, 1)";
    let found = of(&format!("{part}^2*(3 - 2*{part})"), [1.1, 1.2]);
    assert_eq!((found.unjudged, found.branches.len()), (0, 1));
    assert!(found.error.is_some_and(|error| error < 1e-6), "{:?}", found.error);
    let at_once = of("1", [1.1, 1.2]);
    let ends = |found: &lindstedt::response::ResponseDiagram| {
        let points = &found.branches[0].points;
        let mut ends = [&points[0], &points[points.len() - 1]].map(|point| point.peak);
        ends.sort_by(f64::total_cmp);
        ends
    };
    for (one, other) in ends(&found).into_iter().zip(ends(&at_once)) {
        assert!((one - other).abs() < 2e-4, "{one} {other}");
    }
}

//! Equation (7) as anybody would write it down, followed by the integrator of any first-order
//! equations: flight in time, contact in w with x = x_c + w^2 and dt = w ds, each from its event to
//! the next.

use lindstedt::expr::parse_expression;
use lindstedt::impact::{Friction, Model, Regime, Side, Start};
use lindstedt::system::{Event, Path, PathEnd, System, SystemOptions};

use super::taylor;

/// Between two events: in time, or in s with the time among the states.
struct Piece {
    from: f64,
    to: f64,
    path: Path,
    contact: Option<Side>,
}

/// One contact: entry, exit, speeds and depth.
#[derive(Debug)]
struct Contact {
    times: [f64; 2],
    speeds: [f64; 2],
    depth: f64,
}

fn friction(model: &Model) -> &'static str {
    match model.friction {
        Friction::Exact => "alpha*sgn(v)",
        Friction::Arctangent => "2*alpha/pi*atan(100*v)",
    }
}

/// The equations of flight, and those of contact in the mirror of a side.
fn equations(model: &Model, side: Option<Side>) -> System {
    let (sign, barrier) = match side {
        Some(side) => (side.sign(), side.sign() * model.barrier(side).expect("a barrier")),
        None => (1.0, 0.0),
    };
    let numbers = [
        ("zeta", model.zeta),
        ("alpha", model.alpha),
        ("beta", sign * model.beta),
        ("eta", model.frequency_ratio),
        ("gamma", model.gamma),
        ("mu", model.mu),
        ("c", barrier),
    ];
    let friction = friction(model);
    let forces = |x: &str, t: &str| format!("sin({x}) + {friction} - beta*sin(eta*{t})*cos({x})");
    let equations = match side {
        None => vec![("x", "v".to_owned()), ("v", format!("-2*zeta*v - ({})", forces("x", "t")))],
        Some(_) => vec![
            ("w", "v/2".to_owned()),
            (
                "v",
                format!(
                    "-w*({}) - 2*zeta*w*v - max(0, gamma + mu*v)*w^4",
                    forces("(c + w^2)", "T")
                ),
            ),
            ("T", "w".to_owned()),
        ],
    };
    let equations: Vec<(&str, &str)> =
        equations.iter().map(|(state, right)| (*state, right.as_str())).collect();
    System::parse(&equations, &numbers).expect("equations")
}

fn stop(text: String) -> Event {
    Event::stop(parse_expression(&text).expect("an event"))
}

/// The motion in pieces, its contacts, and when it stuck.
fn follow(model: &Model, start: Start, duration: f64) -> (Vec<Piece>, Vec<Contact>, Option<f64>) {
    let options = SystemOptions::default();
    let (mut pieces, mut contacts) = (vec![], vec![]);
    let (mut t, mut x, mut v) = (0.0, start.x, start.velocity);
    loop {
        let [right, left] =
            [Side::Right, Side::Left].map(|side| model.barrier(side).expect("a barrier"));
        let barriers = [right, left].map(|barrier| stop(format!("x - ({barrier:?})")));
        let flight = equations(model, None);
        let path = flight.solve([t, duration], &[x, v], &barriers, &options).expect("a flight");
        let (reason, to) = (path.reason(), path.end());
        v = path.states_at(to).expect("an end")[1];
        pieces.push(Piece { from: t, to, path, contact: None });
        t = to;
        let side = match reason {
            PathEnd::Event(0) => Side::Right,
            PathEnd::Event(_) => Side::Left,
            PathEnd::Sticks => return (pieces, contacts, Some(t)),
            reason => {
                assert_eq!(reason, PathEnd::Reached);
                return (pieces, contacts, None);
            }
        };
        let ends = [
            stop("w".to_owned()),
            stop(format!("T - {duration:?}")),
            Event::record(parse_expression("v").expect("an event")),
        ];
        let (speed, sign) = (v.abs(), side.sign());
        let contact = equations(model, Some(side));
        let path = contact.solve([0.0, 1e9], &[0.0, speed, t], &ends, &options).expect("a contact");
        let end = path.states_at(path.end()).expect("an end");
        let (from, to, reason) = (t, end[2], path.reason());
        let deepest = path.occurrences().iter().find(|met| met.event == 2);
        let depth =
            deepest.map_or(0.0, |met| path.states_at(met.time).expect("a state")[0].powi(2));
        pieces.push(Piece { from, to, path, contact: Some(side) });
        match reason {
            PathEnd::Event(0) => {
                contacts.push(Contact { times: [from, to], speeds: [speed, -end[1]], depth })
            }
            PathEnd::Sticks => return (pieces, contacts, Some(to)),
            reason => {
                assert_eq!(reason, PathEnd::Event(1));
                return (pieces, contacts, None);
            }
        }
        (t, x, v) = (to, model.barrier(side).expect("a barrier"), sign * end[1]);
    }
}

/// Displacement and velocity at a time.
fn at(pieces: &[Piece], model: &Model, time: f64) -> Option<[f64; 2]> {
    let piece = pieces.iter().find(|piece| (piece.from..=piece.to).contains(&time))?;
    let Some(side) = piece.contact else {
        let state = piece.path.states_at(time)?;
        return Some([state[0], state[1]]);
    };
    // T grows with s.
    let (mut low, mut high) = (0.0, piece.path.end());
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        match piece.path.states_at(middle)?[2] < time {
            true => low = middle,
            false => high = middle,
        }
    }
    let state = piece.path.states_at(high)?;
    Some([model.barrier(side)? + side.sign() * state[0].powi(2), side.sign() * state[1]])
}

/// Numbers between 0 and 1 that differ from motion to motion: multiples of irrational numbers.
fn parameters(index: u32) -> [f64; 8] {
    let roots = [2.0_f64, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0];
    roots.map(|root| (f64::from(index + 1) * root.sqrt()).fract())
}

#[test]
fn the_special_integrator_and_that_of_any_equations_agree() {
    let duration = 12.0;
    let (mut impacts, mut stuck, mut detached) = (0, 0, 0);
    for index in 0..60 {
        let [a, b, c, d, e, f, g, h] = parameters(index);
        let model = Model {
            zeta: 0.05 * a,
            alpha: if index % 3 == 0 { 0.0 } else { 0.1 * b },
            friction: if index % 3 == 2 { Friction::Arctangent } else { Friction::Exact },
            beta: if index % 2 == 0 { 0.0 } else { 0.5 * c },
            frequency_ratio: 0.3 + 2.0 * d,
            gamma: 10.0_f64.powf(1.0 + 6.0 * e),
            mu: if index % 4 == 0 { 0.0 } else { 10.0_f64.powf(1.0 + 6.0 * e) * 20.0 * f },
            left: Some(-0.3 - g),
            right: Some(0.1 + 0.6 * h),
        };
        let start = Start { x: 0.05, velocity: 0.6 + g };
        let special = taylor(&model, start, 1e-13, duration);
        let apart = special.path.pieces().iter();
        detached += apart.filter(|piece| matches!(piece.regime, Regime::Detached(_))).count();
        let (pieces, contacts, sticks) = follow(&model, start, duration);
        let until = sticks.unwrap_or(duration);
        if let Some(time) = sticks {
            assert_eq!(
                special.path.regime_at(time + 1e-9),
                Some(Regime::Stuck),
                "{model:?} at {time}"
            );
            stuck += 1;
        }
        let ended = special
            .impacts
            .iter()
            .filter(|impact| impact.exit_time.is_some_and(|exit| exit <= until));
        let ended: Vec<_> = ended.collect();
        assert_eq!(ended.len(), contacts.len(), "{model:?}");
        impacts += contacts.len();
        for (impact, contact) in ended.iter().zip(&contacts) {
            let found = [
                impact.entry_time,
                impact.exit_time.expect("an exit"),
                impact.speed_in,
                impact.speed_out.expect("a speed"),
                impact.penetration,
            ];
            let [entry, exit] = contact.times;
            let [speed_in, speed_out] = contact.speeds;
            for (found, expected) in
                found.into_iter().zip([entry, exit, speed_in, speed_out, contact.depth])
            {
                assert!((found - expected).abs() < 1e-11, "{model:?}: {impact:?} {contact:?}");
            }
        }
        for sample in 0..=240 {
            // Rounding may put the last one behind the end.
            let time = (until * f64::from(sample) / 240.0).min(until);
            let Some([x, v]) = at(&pieces, &model, time) else {
                panic!("{model:?} has no state at {time}");
            };
            let (special_x, special_v) = special.path.phase_point_at(time).expect("a state");
            assert!((x - special_x).abs() < 1e-11, "{model:?} at {time}: {x} {special_x}");
            // In contact the velocity changes by gamma d^(3/2) in a unit of time.
            let steep =
                1.0 + model.contact(model.depth(x).map_or(0.0, |(_, depth)| depth), v.abs());
            assert!((v - special_v).abs() < 1e-11 * steep, "{model:?} at {time}: {v} {special_v}");
        }
    }
    println!("{impacts} impacts, {stuck} stuck, {detached} steps away from a barrier still behind");
    assert!(impacts > 100 && stuck > 2 && detached > 2, "{impacts} {stuck} {detached}");
}

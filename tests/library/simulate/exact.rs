//! Conservative motions against elliptic functions and quadrature, down to grazing contacts.

use lindstedt::impact::{Model, SimulationStop, Start};
use lindstedt::numeric::ode::quadrature::integrate_smooth;
use lindstedt::numeric::ode::root::find_root;

use super::{REST, taylor};

/// The pendulum released at rest from x = -amplitude: sin(x/2) = -k cn/dn, k = sin(amplitude/2).
fn pendulum(amplitude: f64, t: f64) -> (f64, f64) {
    let k = (0.5 * amplitude).sin();
    let (sn, cn, dn, _) = spec_math::cephes64::ellpj(t, k * k);
    (-2.0 * (k * cn / dn).asin(), 2.0 * k * (1.0 - k * k).sqrt() * sn / dn)
}

/// Time from release to touch, time in contact, and depth, of the conservative motion: elliptic F,
/// and from the energy T = 8 sqrt(q_m) int q / sqrt(H) dw with depth = q^2, q = q_m (1 - w^2), v^2
/// = (q_m - q) H.
fn exact_cycle(amplitude: f64, barrier: f64, gamma: f64) -> (f64, f64, f64) {
    let k = (0.5 * amplitude).sin();
    let approach = ellip::ellipk(k * k).expect("m < 1")
        + ellip::ellipf(((0.5 * barrier).sin() / k).asin(), k * k).expect("within reach");
    // 2 (cos(x_c + d) - cos A) as a product, without cancellation at grazing.
    let square = |q: f64| {
        let x = barrier + q * q;
        4.0 * (0.5 * (amplitude + x)).sin() * (0.5 * (amplitude - x)).sin()
            - 0.8 * gamma * q.powi(5)
    };
    let deepest = find_root(square, 0.0, (amplitude - barrier).sqrt()).expect("a depth");
    let slope = |q: f64| 4.0 * q * (barrier + q * q).sin() + 4.0 * gamma * q.powi(4);
    let quotient = |q: f64| {
        integrate_smooth(|u| slope(q + u * (deepest - q)), 0.0, 1.0, 1e-14).expect("smooth").0
    };
    let integrand = |w: f64| {
        let q = deepest * (1.0 - w * w);
        q / quotient(q).sqrt()
    };
    let contact =
        8.0 * deepest.sqrt() * integrate_smooth(integrand, 0.0, 1.0, 1e-13).expect("smooth").0;
    (approach, contact, deepest * deepest)
}

/// The exact conservative motion at any time outside contact.
fn exact_state(amplitude: f64, barrier: f64, gamma: f64, t: f64) -> Option<(f64, f64)> {
    let (approach, contact, _) = exact_cycle(amplitude, barrier, gamma);
    let cycle = 2.0 * approach + contact;
    // Counted from the nearest release.
    let phase = t - cycle * (t / cycle).round();
    let (x, v) = pendulum(amplitude, phase);
    (phase.abs() < approach).then_some((x, v))
}

#[test]
fn the_conservative_motion_is_that_of_elliptic_functions_and_quadrature() {
    for (gamma, barrier) in [(1e6, 0.323), (3.0407e7, 0.323), (1e3, -0.2), (1e16, 0.7)] {
        let model = Model { gamma, right: Some(barrier), ..Model::default() };
        let (approach, contact, depth) = exact_cycle(1.5, barrier, gamma);
        let motion = taylor(&model, REST, 1e-10, 50.0);
        assert_eq!(motion.stop, SimulationStop::Duration);
        let cycle = 2.0 * approach + contact;
        let expected = ((50.0 - approach) / cycle).floor() as usize + 1;
        assert_eq!(motion.impacts.len(), expected, "gamma {gamma}");
        for (number, impact) in motion.impacts.iter().enumerate() {
            let entry = approach + number as f64 * cycle;
            assert!(
                (impact.entry_time - entry).abs() < 1e-10,
                "gamma {gamma}, {number}: {}",
                impact.entry_time - entry
            );
            if let Some(exit) = impact.exit_time {
                assert!((exit - entry - contact).abs() < 1e-10);
                assert!(
                    (impact.penetration / depth - 1.0).abs() < 1e-8,
                    "{} {depth}",
                    impact.penetration
                );
                assert!((impact.restitution.expect("left") - 1.0).abs() < 1e-9);
                assert!(impact.energy_lost.expect("left").abs() < 1e-9);
            }
        }
        let mut compared = 0;
        for index in 0..=500 {
            let t = 0.1 * f64::from(index);
            let (x, v) = motion.path.phase_point_at(t).expect("within the run");
            if let Some((exact_x, exact_v)) = exact_state(1.5, barrier, gamma, t) {
                assert!(
                    (x - exact_x).abs() < 1e-9 && (v - exact_v).abs() < 1e-9,
                    "gamma {gamma}, t {t}: {} {}",
                    x - exact_x,
                    v - exact_v
                );
                compared += 1;
            }
        }
        assert!(compared > 450);
        assert!(motion.energy().residual < 1e-9, "{:?}", motion.energy());
    }
}

#[test]
fn grazing_contacts_are_neither_missed_nor_invented() {
    let gamma = 1e6;
    for part in [0.9, 0.99, 0.999, 0.9999, 0.99999, 0.999_999] {
        let barrier = 1.5 * part;
        let model = Model { gamma, right: Some(barrier), ..Model::default() };
        let (approach, contact, depth) = exact_cycle(1.5, barrier, gamma);
        let cycle = 2.0 * approach + contact;
        let motion = taylor(&model, REST, 1e-12, 50.0);
        let expected = ((50.0 - approach) / cycle).floor() as usize + 1;
        assert_eq!(motion.impacts.len(), expected, "barrier at {part} A");
        for (number, impact) in motion.impacts.iter().enumerate() {
            // A touch at speed v is as well known in time as x is, divided by v.
            let allowed = 1e-10 / impact.speed_in.min(1.0);
            let entry = approach + number as f64 * cycle;
            assert!(
                (impact.entry_time - entry).abs() < allowed,
                "{part}: {}",
                impact.entry_time - entry
            );
            if let Some(exit) = impact.exit_time {
                assert!((exit - impact.entry_time - contact).abs() < 2.0 * allowed);
                assert!((impact.penetration - depth).abs() < 1e-10);
            }
        }
    }
    for beyond in [1.0, 1.0 + 1e-12, 1.000_001, 1.1] {
        let model = Model { right: Some(1.5 * beyond), ..Model::default() };
        let motion = taylor(&model, REST, 1e-13, 200.0);
        // Exactly at A the rounding decides, and what it makes is no impact to speak of.
        let speed = motion.impacts.iter().map(|impact| impact.speed_in).fold(0.0, f64::max);
        if beyond == 1.0 {
            assert!(speed < 1e-6, "{speed}");
        } else {
            assert_eq!(motion.impacts.len(), 0, "barrier at {beyond} A");
        }
        let (x, v) = pendulum(1.5, 200.0);
        assert!((motion.end_x - x).abs() < 1e-9 && (motion.end_velocity - v).abs() < 1e-9);
    }
}

#[test]
fn a_slow_touch_bounces_as_gravity_says() {
    // Thrown against the barrier at a speed that hardly dents it: it is back after 2 v / sin x_c
    // and the depth is v^2 / (2 sin x_c), until the contact force counts.
    for speed in [1e-6, 1e-8, 1e-10] {
        let model = Model { gamma: 1.0, ..Model::default() };
        let start = Start { x: 0.323, velocity: speed };
        let motion = taylor(&model, start, 1e-12, 1.0);
        let impact = motion.impacts[0];
        let force = 0.323_f64.sin();
        let exit = impact.exit_time.expect("it comes back");
        assert!((exit / (2.0 * speed / force) - 1.0).abs() < 1e-5, "{exit}");
        assert!((impact.penetration / (0.5 * speed * speed / force) - 1.0).abs() < 1e-5);
        assert_eq!(motion.impacts.len(), 1);
    }
}

//! The numerical judge: x'' = g(t, x, v), or any first-order equations, integrated by an adaptive
//! Runge-Kutta method, with the whole path kept.
//!
//! In: the right side as a closure, a start, an end time, the events to look for. Out: a
//! [`Trajectory`] that answers x and v, or all values, at any time between, lists the events it
//! met, and says why it stopped. Nothing here knows where the equation came from, so a formula that
//! is judged and its judge share no code.
//!
//! - [`integrate`] follows one smooth right side; [`integrate_phases`] follows several and switches
//!   between them at located events: a step is never trusted across a kink such as the first touch
//!   of a barrier, the run restarts there.
//! - [`integrate_first_order`] follows y' = f(t, y) with any number of values.
//! - [`Event`] is a function of time and values whose zeros are located: [`Event::record`],
//!   [`Event::stop`], [`Event::switch`].
//! - [`energy`] finds where a conservative motion turns and how long it takes on the way;
//! - [`quadrature`] integrates a smooth function, [`root`] finds roots and minima, [`polynomial`]
//!   the zeros of a polynomial, [`newton`] the solution of several equations.
//!
//! ```
//! # use lindstedt_numeric as lindstedt;
//! use lindstedt::numeric::ode::{Event, IntegrationOptions, State, integrate};
//!
//! // The pendulum from 1.5 rad at rest: its first passage through the vertical is a quarter of its period.
//! let pendulum = |_t: f64, x: f64, _v: f64| -x.sin();
//! let start = State { t: 0.0, x: 1.5, v: 0.0 };
//! let vertical = Event::stop(|_t, x, _v| x).falling();
//! let path = integrate(pendulum, start, 10.0, &[vertical], &IntegrationOptions::default())?;
//!
//! let period = std::f64::consts::TAU / 0.860_608_346_679_613;
//! assert!((path.end().t - 0.25 * period).abs() < 1e-9);
//! assert!(path.phase_point_at(1.0).is_some_and(|(x, v)| x > 0.0 && v < 0.0));
//! # Ok::<(), lindstedt::numeric::ode::IntegrationError>(())
//! ```
//!
//! The method is Verner's most efficient 9(8) pair with its own 8th-order interpolant (J. H.
//! Verner, *Numer. Algorithms* 53 (2010) 383), as in the crate `differential-equations`; stiff
//! motions use the Radau IIA method of order 5 of the same crate. The tolerance bounds the error of
//! one step, not of the run: on the pendulum the error after a hundred time units is some 60 times
//! the tolerance. If the values are an array, a step allocates memory only for what is kept of it.

pub mod energy;
mod event;
mod integrate;
mod mean_value;
pub mod newton;
pub mod polynomial;
pub mod quadrature;
pub mod root;
mod sample;
mod scheme;
mod trajectory;
mod verner;

pub use event::{Action, Direction, Event};
pub use integrate::{
    AcceptedFraction, RunEnd, StepLimits, end_or_event, end_values, integrate_through,
};
pub use integrate::{
    IntegrationError, IntegrationOptions, IntegrationPhase, integrate, integrate_first_order,
    integrate_phases,
};
pub use sample::{Point, Sample, StateVector};
pub use trajectory::{EventOccurrence, StopReason, Trajectory};

/// A point of the motion: time, displacement, velocity. Also the initial condition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Time.
    pub t: f64,
    /// Displacement x.
    pub x: f64,
    /// Velocity x'.
    pub v: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use quadrature::integrate_smooth;
    use root::find_root;

    const REST: State = State { t: 0.0, x: 1.5, v: 0.0 };

    fn pendulum(_t: f64, x: f64, _v: f64) -> f64 {
        -x.sin()
    }

    /// The pendulum released at rest from `amplitude`: sin(x/2) = k cn(t)/dn(t), k =
    /// sin(amplitude/2).
    fn exact_pendulum(amplitude: f64, t: f64) -> (f64, f64) {
        let k = (0.5 * amplitude).sin();
        let (sn, cn, dn, _) = spec_math::cephes64::ellpj(t, k * k);
        let x = 2.0 * (k * cn / dn).asin();
        // d/dt (cn/dn) = -(1 - m) sn/dn^2 and cos(x/2) = sqrt(1 - m)/dn.
        let v = -2.0 * k * (1.0 - k * k).sqrt() * sn / dn;
        (x, v)
    }

    #[test]
    fn the_reference_satisfies_the_pendulum_and_its_energy() {
        for index in 0..200 {
            let t = 0.1 * f64::from(index);
            let (x, v) = exact_pendulum(1.5, t);
            assert!((0.5 * v * v - x.cos() + 1.5_f64.cos()).abs() < 1e-13, "energy at {t}");
            let step = 1e-3;
            let curvature = (exact_pendulum(1.5, t + step).0 - 2.0 * x
                + exact_pendulum(1.5, t - step).0)
                / (step * step);
            assert!((curvature + x.sin()).abs() < 1e-6, "equation at {t}");
        }
    }

    #[test]
    fn the_dense_output_follows_the_elliptic_functions() {
        // (tolerance, largest error allowed up to t = 100): about a hundred times the tolerance.
        for (tolerance, allowed) in [(1e-12, 1e-10), (1e-9, 2e-7), (1e-6, 2e-3)] {
            let path = integrate(
                pendulum,
                REST,
                100.0,
                &[],
                &IntegrationOptions::with_tolerance(tolerance),
            )
            .unwrap();
            assert_eq!(path.stop_reason(), StopReason::EndReached);
            assert_eq!(path.end().t, 100.0);
            let mut worst = 0.0_f64;
            for state in path.samples(10_001) {
                let (x, v) = exact_pendulum(1.5, state.t);
                worst = worst.max((state.x - x).abs()).max((state.v - v).abs());
            }
            assert!(worst < allowed, "tolerance {tolerance}: error {worst}");
            assert!(path.step_count() < 1000 && path.evaluations() < 30 * path.step_count());
        }
    }

    #[test]
    fn between_the_knots_it_is_as_good_as_at_the_knots() {
        let path = integrate(pendulum, REST, 20.0, &[], &IntegrationOptions::with_tolerance(1e-10))
            .unwrap();
        let error = |t: f64| (path.phase_point_at(t).unwrap().0 - exact_pendulum(1.5, t).0).abs();
        let at_knots = path.knots().map(|knot| error(knot.t)).fold(0.0, f64::max);
        let anywhere = path.samples(5000).map(|state| error(state.t)).fold(0.0, f64::max);
        assert!(anywhere < 3.0 * at_knots, "{anywhere} between, {at_knots} at the knots");
        assert!(
            path.phase_point_at(-1e-9).is_none()
                && path.phase_point_at(20.000_001).is_none()
                && path.phase_point_at(f64::NAN).is_none()
        );
        assert_eq!(path.phase_point_at(0.0), Some((1.5, 0.0)));
    }

    #[test]
    fn events_are_located_to_the_accuracy_of_the_run() {
        let quarter = ellip::ellipk(0.75_f64.sin().powi(2)).unwrap();
        let events = [
            Event::record(|_, x, _| x),
            Event::record(|_, _, v| v).rising(),
            Event::record(|t, _, _| t - 5.0),
        ];
        let path =
            integrate(pendulum, REST, 30.0, &events, &IntegrationOptions::with_tolerance(1e-12))
                .unwrap();
        let times = |event| {
            path.occurrences().iter().filter(move |found| found.event == event).map(|it| it.state.t)
        };
        let crossings: Vec<f64> = times(0).collect();
        assert_eq!(crossings.len(), (30.0 / quarter - 1.0) as usize / 2 + 1);
        for (index, time) in crossings.iter().enumerate() {
            assert!(
                (time - quarter * (2 * index + 1) as f64).abs() < 2e-11,
                "crossing {index} at {time}"
            );
        }
        // v goes from negative to positive at half a period, and not at the start, where it is zero
        // too.
        for (index, time) in times(1).enumerate() {
            assert!(
                (time - quarter * (4 * index + 2) as f64).abs() < 2e-11,
                "turning point {index} at {time}"
            );
        }
        assert_eq!(times(2).collect::<Vec<_>>(), [5.0]);
        assert!(path.occurrences().windows(2).all(|pair| pair[0].state.t <= pair[1].state.t));
    }

    #[test]
    fn a_stop_ends_the_path_at_the_event() {
        let path = integrate(
            pendulum,
            REST,
            30.0,
            &[Event::stop(|_, x, _| x - 1.0).falling()],
            &IntegrationOptions::default(),
        )
        .unwrap();
        assert_eq!(path.stop_reason(), StopReason::Event { phase: 0, event: 0 });
        assert!((path.end().x - 1.0).abs() < 1e-15 && path.is_complete());
        assert_eq!(path.occurrences().len(), 1);
        let time = find_root(|t| exact_pendulum(1.5, t).0 - 1.0, 0.5, 1.8).unwrap();
        assert!((path.end().t - time).abs() < 1e-9);
    }

    #[test]
    fn crossings_that_only_just_happen_are_not_missed() {
        // x = cos t against a wall at x_w: 2 crossings a period, arccos(x_w) before and after each
        // crest.
        let oscillator = |_: f64, x: f64, _: f64| -x;
        let start = State { t: 0.0, x: 0.0, v: 1.0 };
        let end_time = 20.0 * std::f64::consts::PI;
        for (tolerance, wall) in [
            (1e-6, 0.9),
            (1e-6, 0.99),
            (1e-6, 0.9999),
            (1e-10, 0.999_999),
            (1e-12, 1.0 - 1e-8),
            (1e-12, 1.0 - 1e-10),
        ] {
            for (direction, expected) in
                [(Direction::Either, 20), (Direction::Rising, 10), (Direction::Falling, 10)]
            {
                let event = Event { direction, ..Event::record(move |_, x, _| x - wall) };
                let path = integrate(
                    oscillator,
                    start,
                    end_time,
                    &[event],
                    &IntegrationOptions::with_tolerance(tolerance),
                )
                .unwrap();
                assert_eq!(
                    path.occurrences().len(),
                    expected,
                    "wall {wall}, tolerance {tolerance}, {direction:?}"
                );
            }
            let beyond = Event::record(move |_, x, _| x - (2.0 - wall));
            let path = integrate(
                oscillator,
                start,
                end_time,
                &[beyond],
                &IntegrationOptions::with_tolerance(tolerance),
            )
            .unwrap();
            assert!(path.occurrences().is_empty(), "wall {} is never reached", 2.0 - wall);
        }
    }

    /// Pendulum and barrier, x'' + sin x + gamma (x - x_c)_+^(3/2) = 0, switched at the barrier.
    fn pendulum_and_barrier(barrier: f64, gamma: f64) -> Vec<IntegrationPhase<'static>> {
        let snapped = move |state: State| State { x: barrier, ..state };
        let reach =
            Event::switch(move |_, x, _| x - barrier, move |state| (1, snapped(state))).rising();
        let leave =
            Event::switch(move |_, x, _| x - barrier, move |state| (0, snapped(state))).falling();
        let contact =
            move |_: f64, x: f64, _: f64| -x.sin() - gamma * (x - barrier).max(0.0).powf(1.5);
        vec![
            IntegrationPhase::new(pendulum, vec![reach]),
            IntegrationPhase::new(contact, vec![leave]),
        ]
    }

    /// Time of approach and of contact, from the energy: elliptic F, and T_c = 8 sqrt(q_m) int q /
    /// sqrt(H) dw with depth = q^2, q = q_m (1 - w^2) and v^2 = (q_m - q) H.
    fn exact_times(amplitude: f64, barrier: f64, gamma: f64) -> (f64, f64) {
        let k = (0.5 * amplitude).sin();
        let approach = ellip::ellipk(k * k).unwrap()
            + ellip::ellipf(((0.5 * barrier).sin() / k).asin(), k * k).unwrap();
        let square =
            |q: f64| 2.0 * ((barrier + q * q).cos() - amplitude.cos()) - 0.8 * gamma * q.powi(5);
        let deepest = find_root(square, 0.0, 1.0).unwrap();
        // H from the mean slope of v^2 between q and q_m: a divided difference without
        // cancellation.
        let slope = |q: f64| 4.0 * q * (barrier + q * q).sin() + 4.0 * gamma * q.powi(4);
        let quotient =
            |q: f64| integrate_smooth(|u| slope(q + u * (deepest - q)), 0.0, 1.0, 1e-14).unwrap().0;
        let integrand = |w: f64| {
            let q = deepest * (1.0 - w * w);
            q / quotient(q).sqrt()
        };
        (approach, 8.0 * deepest.sqrt() * integrate_smooth(integrand, 0.0, 1.0, 1e-13).unwrap().0)
    }

    #[test]
    fn twenty_four_crossings_of_the_barrier_at_their_exact_times() {
        let (approach, contact) = exact_times(1.5, 0.323, 1e6);
        assert!(
            (approach - 2.064_407_608_58).abs() < 1e-11
                && (contact - 0.012_106_027_06).abs() < 1e-11
        );
        let start = State { t: 0.0, x: -1.5, v: 0.0 };
        for (gamma, tolerance, allowed) in
            [(1e6, 1e-12, 2e-10), (1e9, 1e-12, 3e-10), (1e6, 1e-9, 1.5e-7)]
        {
            let (approach, contact) = exact_times(1.5, 0.323, gamma);
            let phases = pendulum_and_barrier(0.323, gamma);
            let path = integrate_phases(
                &phases,
                0,
                start,
                50.0,
                &IntegrationOptions::with_tolerance(tolerance),
            )
            .unwrap();
            assert_eq!(path.occurrences().len(), 24, "gamma {gamma}");
            for (index, found) in path.occurrences().iter().enumerate() {
                let exit = index % 2;
                let time = approach
                    + (index / 2) as f64 * (2.0 * approach + contact)
                    + exit as f64 * contact;
                assert_eq!((found.phase, found.event), (exit, 0));
                assert!(
                    (found.state.t - time).abs() < allowed,
                    "gamma {gamma}: crossing {index} at {}",
                    found.state.t
                );
                assert_eq!(path.phase_point_at(found.state.t).unwrap().0, 0.323);
                assert_eq!(path.phase_at(found.state.t), Some(1 - exit));
            }
        }
    }

    #[test]
    fn a_grazing_start_leaves_the_surface_again() {
        // On the barrier with almost no speed: gravity brings it back within 2 v / sin(x_c).
        for speed in [1e-3, 1e-6, 1e-9, 1e-12] {
            let start = State { t: 0.0, x: 0.323, v: speed };
            let path = integrate_phases(
                &pendulum_and_barrier(0.323, 1e3),
                1,
                start,
                1.0,
                &IntegrationOptions::default(),
            )
            .unwrap();
            assert_eq!(path.occurrences().len(), 1, "speed {speed}: {:?}", path.occurrences());
            let exit = path.occurrences()[0].state;
            let expected = 2.0 * speed / 0.323_f64.sin();
            // An excursion of speed^2 below the rounding of x is left at once.
            let allowed = (0.2 * expected).max(1e-8);
            assert!(
                (exit.t - expected).abs() < allowed,
                "speed {speed}: exit at {} against {expected}",
                exit.t
            );
        }
    }

    #[test]
    fn a_bouncing_ball_stalls_where_its_bounces_accumulate() {
        // Dropped from height 1/2 with restitution 1/2: first touch at t = 1, the bounces end at
        // t = 1 + 2 (1/2 + 1/4 + ...).
        let rebound =
            Event::switch(|_, x, _| x, |state| (0, State { x: 0.0, v: -0.5 * state.v, ..state }))
                .falling();
        let start = State { t: 0.0, x: 0.5, v: 0.0 };
        let path =
            integrate(|_, _, _| -1.0, start, 10.0, &[rebound], &IntegrationOptions::default())
                .unwrap();
        for (bounce, time) in [1.0, 2.0, 2.5, 2.75].into_iter().enumerate() {
            assert!((path.occurrences()[bounce].state.t - time).abs() < 1e-11);
        }
        assert!(
            matches!(path.stop_reason(), StopReason::SwitchingStalled { .. }),
            "{}",
            path.stop_reason()
        );
        assert!((path.end().t - 3.0).abs() < 1e-10 && !path.is_complete());
    }

    #[test]
    fn a_run_that_cannot_go_on_says_when_and_keeps_what_it_has() {
        // x = 1/(1 - t)^2 escapes at t = 1.
        let start = State { t: 0.0, x: 1.0, v: 2.0 };
        let path =
            integrate(|_, x, _| 6.0 * x * x, start, 3.0, &[], &IntegrationOptions::default())
                .unwrap();
        assert!(!path.is_complete() && (path.end().t - 1.0).abs() < 1e-3, "{}", path.stop_reason());
        assert!((path.phase_point_at(0.5).unwrap().0 - 4.0).abs() < 1e-7);

        // Beyond x = 1 there is no acceleration; x = t gets there at t = 1.
        let start = State { t: 0.0, x: 0.0, v: 1.0 };
        let path = integrate(
            |_, x, _| 0.0 * (1.0 - x).sqrt(),
            start,
            3.0,
            &[],
            &IntegrationOptions::default(),
        )
        .unwrap();
        let StopReason::NonFinite { time } = path.stop_reason() else {
            panic!("{}", path.stop_reason())
        };
        assert!((time - 1.0).abs() < 1e-12);
        assert!((path.phase_point_at(0.75).unwrap().0 - 0.75).abs() < 1e-12);

        let few = IntegrationOptions { maximum_steps: 5, ..IntegrationOptions::default() };
        let path = integrate(pendulum, REST, 30.0, &[], &few).unwrap();
        assert_eq!(path.stop_reason(), StopReason::MaximumSteps { time: path.end().t });

        let broken = Event::record(|t, _, _| (1.0 - t).ln());
        let path =
            integrate(pendulum, REST, 30.0, &[broken], &IntegrationOptions::default()).unwrap();
        assert!(matches!(path.stop_reason(), StopReason::NonFinite { time } if time < 1.0));
    }

    /// A stop of stiffness 1e6 that is touched for a moment, so that a step goes past the touch: its
    /// interpolant knows the force there, the motion up to the stop does not. v^2 = A^2 - d^2. A
    /// touch that hides between the stages of a step is not met at all, which is rare.
    #[test]
    fn a_stop_is_met_as_the_motion_up_to_it_leads_however_short_the_touch() {
        let (stop, depth): (f64, f64) = (0.5, 2e-7);
        let amplitude = stop + depth;
        let speed = (depth * (amplitude + stop)).sqrt();
        for (tolerance, within) in [(1e-10, 1e-2), (1e-12, 1e-4)] {
            let mut met = 0;
            for part in 0..100 {
                let phase = 3.0 + 0.01 * f64::from(part);
                let (x, v) = (amplitude * phase.cos(), -amplitude * phase.sin());
                let force = |_: f64, x: f64, _: f64| -x - 1e6 * (x - stop).max(0.0).powf(1.5);
                let touch = [Event::stop(|_, x, _| x - stop)];
                let options = IntegrationOptions::with_tolerance(tolerance);
                let path = integrate(force, State { t: 0.0, x, v }, 5.0, &touch, &options).unwrap();
                if matches!(path.stop_reason(), StopReason::Event { .. }) {
                    let error = (path.end().v / speed - 1.0).abs();
                    assert!(error < within, "{tolerance:e} {phase}: {error:e}");
                    met += 1;
                }
            }
            assert!(met >= 95, "{tolerance:e}: {met}");
        }
    }

    /// A surface that is recorded and switched on: each passage is recorded once.
    #[test]
    fn an_event_at_the_same_time_as_a_switch_is_recorded() {
        for part in 0..100 {
            let phase = 0.031 * f64::from(part);
            let start = State { t: 0.0, x: phase.cos(), v: -phase.sin() };
            let passed = || Event::record(|_, x, _| x - 0.3);
            let side = |next: usize| Event::switch(|_, x, _| x - 0.3, move |state| (next, state));
            let phases = [
                IntegrationPhase::new(|_, x, _| -x, vec![passed(), side(1).falling()]),
                IntegrationPhase::new(|_, x, _| -x, vec![passed(), side(0).rising()]),
            ];
            let first = usize::from(start.x < 0.3);
            let options = IntegrationOptions::with_tolerance(1e-12);
            let path = integrate_phases(&phases, first, start, 20.0, &options).unwrap();
            let recorded = path.occurrences().iter().filter(|found| found.event == 0).count();
            let switched = path.occurrences().iter().filter(|found| found.event == 1).count();
            assert!(switched >= 6, "{phase}: {switched}");
            assert_eq!(recorded, switched, "{phase}");
        }
    }

    #[test]
    fn what_cannot_begin_is_refused() {
        let refuse = |start, end_time, options: IntegrationOptions| {
            integrate(pendulum, start, end_time, &[], &options).unwrap_err()
        };
        let usual = IntegrationOptions::default();
        assert!(matches!(
            refuse(State { x: f64::NAN, ..REST }, 1.0, usual),
            IntegrationError::NotFinite { .. }
        ));
        assert!(matches!(refuse(REST, f64::INFINITY, usual), IntegrationError::NotFinite { .. }));
        assert!(matches!(refuse(REST, -1.0, usual), IntegrationError::EndBeforeStart { .. }));
        for tolerance in [0.0, -1e-9, f64::NAN, 1e-17, 1.0] {
            assert!(matches!(
                refuse(REST, 1.0, IntegrationOptions::with_tolerance(tolerance)),
                IntegrationError::Tolerance(_)
            ));
        }
        let backwards = IntegrationOptions { maximum_step: -1.0, ..usual };
        assert!(matches!(refuse(REST, 1.0, backwards), IntegrationError::MaximumStep(_)));
        let nowhere = |_: f64, x: f64, _: f64| (x - 2.0).sqrt();
        let refused = integrate(nowhere, REST, 1.0, &[], &usual).unwrap_err();
        assert!(matches!(refused, IntegrationError::AccelerationNotFinite { .. }));
        let refused =
            integrate_phases(&pendulum_and_barrier(0.323, 1e6), 2, REST, 1.0, &usual).unwrap_err();
        assert_eq!(refused, IntegrationError::UnknownPhase { phase: 2, count: 2 });
        let path = integrate(pendulum, REST, 0.0, &[], &usual).unwrap();
        assert_eq!((path.end(), path.phase_point_at(0.0)), (REST, Some((1.5, 0.0))));
    }

    #[test]
    fn scales_of_amplitude_and_time_change_nothing() {
        // x'' = -omega^2 x from `amplitude`: omega from 1e-6 to 1e9, amplitude down to 1e-9 with a
        // matching tolerance.
        for (omega, amplitude) in [(1e-6, 1.0), (1e9, 1.0), (1.0, 1e-9), (1e3, 1e6)] {
            let options = IntegrationOptions {
                absolute_tolerance: 1e-12 * amplitude,
                ..IntegrationOptions::with_tolerance(1e-12)
            };
            let start = State { t: 0.0, x: amplitude, v: 0.0 };
            let path = integrate(|_, x, _| -omega * omega * x, start, 20.0 / omega, &[], &options)
                .unwrap();
            for state in path.samples(200) {
                assert!(
                    (state.x / amplitude - (omega * state.t).cos()).abs() < 1e-10,
                    "omega {omega}, {amplitude}"
                );
            }
        }
    }
}

//! Impacts in proved numbers, held against elliptic integrals of another crate, quadrature in other
//! variables, Runge-Kutta, and exact relations.

use lindstedt::certificate::{
    Enclosure, ImpactEnclosure, NotEnclosed, PowerLaw, enclose_dashpot_impact, enclose_impact,
    enclose_lossy_impact,
};
use lindstedt::exact::{Rational, from_f64, to_f64};
use lindstedt::expr::Expr;
use lindstedt::impact::contact::{Dashpot, LossyLaw};
use lindstedt::impact::{ContactLoss, Impact, LossAmount, Setup, solve};
use num_traits::Signed as _;
use proptest::prelude::*;

fn fraction(above: i64, below: i64) -> Rational {
    Rational::new(above.into(), below.into())
}

fn exact(value: f64) -> Rational {
    from_f64(value).expect("a finite number")
}

fn enclosed(amplitude: f64, barrier: f64, stiffness: f64) -> Result<ImpactEnclosure, NotEnclosed> {
    enclose_impact(&exact(amplitude), &exact(barrier), &[PowerLaw::hertz(exact(stiffness))])
}

/// Whether a double is what is enclosed, but for its own relative error.
fn agrees(enclosure: &Enclosure, value: f64, error: f64) -> bool {
    let apart = (to_f64(&enclosure.middle) - value).abs();
    apart <= error * value.abs() + enclosure.radius.value()
}

/// `2 int_0^dm dd/sqrt(G)` with `d = dm sin^2(s)`, by the midpoint rule.
fn duration(barrier: f64, stiffness: f64, deepest: f64) -> f64 {
    const POINTS: u32 = 4000;
    let step = std::f64::consts::FRAC_PI_2 / f64::from(POINTS);
    let speeds = (0..POINTS).map(|point| {
        let (sine, cosine) = (step * (f64::from(point) + 0.5)).sin_cos();
        let depth = deepest * sine * sine;
        // G(d) - G(dm) without cancellation: a product of two sines, and a quotient of powers.
        let (mean, half) = (barrier + 0.5 * (depth + deepest), 0.5 * (deepest - depth));
        let swing = 4.0 * mean.sin() * half.sin();
        let (q, qm) = (depth.sqrt(), deepest.sqrt());
        let powers = qm.powi(4) + qm.powi(3) * q + qm * qm * q * q + qm * q.powi(3) + q.powi(4);
        let elastic = 0.8 * stiffness * (deepest - depth) / (qm + q) * powers;
        2.0 * deepest * sine * cosine / (swing + elastic).sqrt()
    });
    2.0 * step * speeds.sum::<f64>()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn other_ways_to_the_numbers_agree(amplitude in 0.3..2.9_f64, place in -0.9..0.9_f64, digits in 1.5..10.0_f64) {
        let (barrier, stiffness) = (place * amplitude.min(1.2), 10.0_f64.powf(digits));
        let Ok(impact) = enclosed(amplitude, barrier, stiffness) else {
            // Only what goes deep is not proved.
            prop_assert!(digits < 3.0 && amplitude > 1.0);
            return Ok(());
        };
        let speed = (2.0 * (barrier.cos() - amplitude.cos())).sqrt();
        prop_assert!(agrees(&impact.speed, speed, 1e-13 / (speed * speed).min(1.0)), "{impact:?}");
        let modulus = (0.5 * amplitude).sin();
        let angle = ((0.5 * barrier).sin() / modulus).asin();
        let quarter = ellip::ellipk(modulus * modulus).expect("K");
        let beyond = ellip::ellipf(angle, modulus * modulus).expect("F");
        prop_assert!(agrees(&impact.time_to_contact, quarter + beyond, 1e-12), "{impact:?}");
        let deepest = to_f64(&impact.penetration.middle);
        let lasts = duration(barrier, stiffness, deepest);
        prop_assert!(agrees(&impact.duration, lasts, 1e-7), "{lasts} {impact:?}");
        // At the deepest point all energy of the touch is in the swing and in the barrier.
        let energy = 2.0 * ((barrier + deepest).cos() - barrier.cos()) + speed * speed;
        prop_assert!((energy - 0.8 * stiffness * deepest.powf(2.5)).abs() < 1e-11 * (1.0 + speed * speed));
    }
}

/// All five numbers are proved to 30 digits and more, and the period is the sum of its phases.
#[test]
fn thirty_digits_and_their_sum() {
    for (amplitude, barrier, stiffness) in
        [(1.5, 0.323, 3e7), (1.5, 0.323, 4.2e9), (0.5, -0.25, 1e4), (3.0, 0.0, 10.0)]
    {
        let impact = enclosed(amplitude, barrier, stiffness).expect("a proof");
        for (name, enclosure) in impact.in_order() {
            let relative = enclosure.radius.value() / to_f64(&enclosure.middle);
            assert!(relative < 1e-30, "{name}: {relative}");
        }
        let sum = fraction(2, 1) * &impact.time_to_contact.middle + &impact.duration.middle;
        let apart = to_f64(&(sum - &impact.period.middle)).abs();
        assert!(apart <= impact.period.radius.value());
    }
}

/// Barriers of other powers of the depth: the energy at the deepest point, and the duration by quadrature, of a linear
/// spring without a swing to speak of half a period of its own.
#[test]
fn every_power_of_the_depth_is_proved() {
    for (above, below) in [(1, 2), (1, 1), (2, 1), (5, 2), (4, 1)] {
        let law = PowerLaw { stiffness: fraction(1_000_000, 1), exponent: fraction(above, below) };
        let impact =
            enclose_impact(&fraction(3, 2), &fraction(323, 1000), &[law]).expect("a proof");
        let [speed, deepest, duration] =
            [&impact.speed, &impact.penetration, &impact.duration].map(|own| to_f64(&own.middle));
        let exponent = above as f64 / below as f64;
        let elastic = |depth: f64| 2e6 * depth.powf(exponent + 1.0) / (exponent + 1.0);
        let swing = |depth: f64| 2.0 * (0.323_f64.cos() - (0.323 + depth).cos());
        let left = speed * speed - swing(deepest) - elastic(deepest);
        assert!(left.abs() < 1e-11, "{exponent}: {left}");
        // With d = dm (1 - s^2) the integrand is smooth at the deepest point, where it is cut off.
        let points = 20_000_u32;
        let step = 1.0 / f64::from(points);
        let integrand = |s: f64| {
            let depth = deepest * (1.0 - s * s);
            let square = swing(deepest) - swing(depth) + elastic(deepest) - elastic(depth);
            4.0 * deepest * s / square.sqrt()
        };
        let middles = (0..points).map(|point| step * (f64::from(point) + 0.5));
        let by_quadrature = step * middles.map(integrand).sum::<f64>();
        assert!(
            (by_quadrature / duration - 1.0).abs() < 1e-4,
            "{exponent}: {by_quadrature} {duration}"
        );
        for (name, number) in impact.in_order() {
            assert!(number.radius.value() < 1e-30 * to_f64(&number.middle), "{exponent}: {name}");
        }
    }
    let spring = PowerLaw { stiffness: fraction(100_000_000, 1), exponent: fraction(1, 1) };
    let impact = enclose_impact(&fraction(1, 1), &fraction(0, 1), &[spring]).expect("a proof");
    let half_period = std::f64::consts::PI / (1e8_f64 + 1.0).sqrt();
    assert!(agrees(&impact.duration, half_period, 1e-14), "{impact:?}");
    let third = PowerLaw { stiffness: fraction(1000, 1), exponent: fraction(1, 3) };
    let refused = enclose_impact(&fraction(3, 2), &fraction(323, 1000), &[third]);
    assert_eq!(refused.expect_err("no half of a whole number"), NotEnclosed::Exponent);
}

/// The harder the barrier, the less the swing acts during the contact: its duration times
/// `gamma^(2/5) v^(1/5)` tends to the constant of Hertz,
/// `2 (5/4)^(2/5) int_0^1 dz/sqrt(1 - z^(5/2))`.
#[test]
fn a_hard_barrier_takes_the_time_of_hertz() {
    // z = 1 - s^2 makes the integrand smooth.
    let points = 20_000_u32;
    let step = 1.0 / f64::from(points);
    let integrand = |s: f64| 2.0 * s / (1.0 - (1.0 - s * s).powf(2.5)).sqrt();
    let middles = (0..points).map(|point| step * (f64::from(point) + 0.5));
    let constant = 2.0 * 1.25_f64.powf(0.4) * step * middles.map(integrand).sum::<f64>();
    let errors = [1e6, 1e8, 1e10].map(|stiffness: f64| {
        let impact = enclosed(1.0, 0.0, stiffness).expect("a proof");
        let speed = to_f64(&impact.speed.middle);
        let scaled = to_f64(&impact.duration.middle) * stiffness.powf(0.4) * speed.powf(0.2);
        (scaled / constant - 1.0).abs()
    });
    assert!(errors[2] < 1e-6 && errors[1] < 0.2 * errors[0], "{errors:?}");
}

/// Runge-Kutta is within its own errors of what is proved; the closed forms are as far off as is
/// said.
#[test]
fn runge_kutta_is_as_good_as_it_says() {
    let setup = Setup { stiffness: 1e6, ..Setup::default() };
    let proved = enclose_impact(
        &fraction(3, 2),
        &fraction(323, 1000),
        &[PowerLaw::hertz(fraction(1_000_000, 1))],
    )
    .expect("a proof");
    let impact = solve(setup).expect("an impact");
    for (quantity, (name, truth)) in impact.quantities().into_iter().zip(proved.in_order()) {
        assert_eq!(quantity.name, name);
        assert!(truth.relative_error(quantity.runge_kutta).upper < 1e-8, "{name}");
        for (value, error) in quantity.closed_forms.iter().zip(quantity.errors()) {
            let range = truth.relative_error(*value);
            assert!(range.lower <= range.upper && range.upper - range.lower < 1e-14);
            assert!((range.upper - error.abs()).abs() < 1e-8, "{name}: {range:?} {error}");
        }
    }
}

#[test]
fn relative_errors_are_rounded_outwards() {
    let proved =
        enclose_impact(&fraction(3, 2), &fraction(0, 1), &[PowerLaw::hertz(fraction(1000, 1))])
            .expect("a proof");
    for parts in [-1e-3, -1e-9, 1e-12, 0.25] {
        let value = to_f64(&proved.speed.middle) * (1.0 + parts);
        let range = proved.speed.relative_error(value);
        let apart = (exact(value) / &proved.speed.middle - fraction(1, 1)).abs();
        let slack = exact(2.0 * proved.speed.radius.value());
        assert!(exact(range.lower) <= &apart + &slack, "{range:?}");
        assert!(exact(range.upper) >= &apart - &slack, "{range:?}");
        assert!(range.upper - range.lower <= 1e-15, "{range:?}");
    }
    assert_eq!(proved.speed.relative_error(f64::NAN).upper, f64::INFINITY);
}

#[test]
fn what_is_no_impact_is_refused() {
    use NotEnclosed::{Barrier, Deep, Release, Stiffness};
    for (amplitude, barrier, stiffness, why) in [
        (3.2, 0.3, 1e6, Release),
        (0.0, 0.3, 1e6, Release),
        (-1.5, 0.3, 1e6, Release),
        (1.5, 1.5, 1e6, Barrier),
        (1.5, -1.6, 1e6, Barrier),
        (2.5, 1.7, 1e6, Barrier),
        (1.5, 0.3, 0.0, Stiffness),
        (1.5, 0.3, -1.0, Stiffness),
        (3.0, 1.5, 1.0, Deep),
    ] {
        let found = enclosed(amplitude, barrier, stiffness);
        assert_eq!(found.expect_err("no proof"), why, "{amplitude} {barrier} {stiffness}");
    }
    // What is extreme ends in a refusal or in numbers, and in time.
    for stiffness in [1e-300, 1e-12, 1e40, 1e300] {
        if let Ok(impact) = enclosed(1.5, 0.3, stiffness) {
            assert!(
                impact.duration.radius.value() < to_f64(&impact.duration.middle),
                "{stiffness}"
            );
        }
    }
}

/// A contact without damping is proved twice, by the integrals of its energy and by the integration of its motion:
/// both intervals hold the same number, for every power of the depth.
#[test]
fn without_damping_the_integration_proves_what_the_energy_does() {
    for (above, below) in [(1, 2), (1, 1), (3, 2), (4, 1)] {
        let law =
            [PowerLaw { stiffness: fraction(1_000_000, 1), exponent: fraction(above, below) }];
        let (amplitude, barrier, none) = (fraction(3, 2), fraction(-323, 1000), fraction(0, 1));
        let by_energy = enclose_impact(&amplitude, &barrier, &law).expect("a proof");
        let by_motion = enclose_lossy_impact(&amplitude, &barrier, &law, &none).expect("a proof");
        for ((name, one), (_, other)) in by_energy.in_order().into_iter().zip(by_motion.in_order())
        {
            let apart = to_f64(&(&one.middle - &other.middle).abs());
            assert!(apart <= one.radius.value() + other.radius.value(), "{name}: {apart}");
            assert!(other.radius.value() < 1e-28 * to_f64(&other.middle), "{name}: {other:?}");
        }
        let [(_, restitution), (_, exit)] = by_motion.losses().expect("a loss");
        assert!(
            agrees(restitution, 1.0, 1e-15) && agrees(exit, to_f64(&by_motion.speed.middle), 1e-15)
        );
    }
}

/// Two halves of a barrier are the whole one, which is proved by the energy; and of a sum of different powers
/// Runge-Kutta finds what is proved.
#[test]
fn a_force_that_is_a_sum_of_powers_is_proved() {
    let (amplitude, barrier) = (fraction(3, 2), fraction(323, 1000));
    let halves = [PowerLaw::hertz(fraction(400_000, 1)), PowerLaw::hertz(fraction(600_000, 1))];
    let whole = [PowerLaw::hertz(fraction(1_000_000, 1))];
    let [one, other] = [&halves[..], &whole[..]]
        .map(|force| enclose_impact(&amplitude, &barrier, force).expect("a proof"));
    for ((name, one), (_, other)) in one.in_order().into_iter().zip(other.in_order()) {
        let apart = to_f64(&(&one.middle - &other.middle).abs());
        assert!(apart <= one.radius.value() + other.radius.value(), "{name}: {apart}");
        assert!(one.radius.value() < 1e-28 * to_f64(&one.middle), "{name}: {one:?}");
    }
    let force: Expr = "gamma*d^(3/2) + 20*gamma*d^2".parse().expect("a force");
    let exactly = force.substitute("gamma".into(), &Expr::from(100_000)).expect("numbers");
    let laws = PowerLaw::sum_of(&exactly, "d".into()).expect("powers").expect("a sum");
    assert_eq!(laws.len(), 2);
    let impact = enclose_impact(&amplitude, &barrier, &laws).expect("a proof");
    assert_eq!(impact.loss, None);
    let setup = Setup { stiffness: 1e5, force: Some(force), ..Setup::default() };
    let solved = solve(setup).expect("an impact");
    for (quantity, (name, truth)) in solved.quantities().into_iter().zip(impact.in_order()) {
        assert!(agrees(truth, quantity.runge_kutta, 1e-9), "{name}: {truth:?}");
    }
}

/// Runge-Kutta finds every number of a contact that loses energy, and those of the loss are sharp.
fn assert_losses_are_those_of_runge_kutta(solved: &Impact, impact: &ImpactEnclosure) {
    let stiffness = solved.setup.stiffness;
    for (quantity, (name, truth)) in solved.quantities().into_iter().zip(impact.in_order()) {
        assert!(agrees(truth, quantity.runge_kutta, 1e-9), "{name} at {stiffness}: {truth:?}");
    }
    let (judged, _) = solved.losses().expect("a loss");
    for (quantity, (name, truth)) in judged.iter().zip(impact.losses().expect("a loss")) {
        assert!(agrees(truth, quantity.runge_kutta, 1e-9), "{name} at {stiffness}: {truth:?}");
        assert!(truth.radius.value() < 1e-28, "{name} at {stiffness}: {truth:?}");
    }
}

/// The harder a barrier of Hunt and Crossley, the less the swing acts during the contact, whose restitution e then
/// obeys `G(-lambda e v) = G(lambda v)` with `G(z) = z - ln(1 + z)`; Runge-Kutta agrees at every hardness.
#[test]
fn a_contact_that_loses_energy_is_proved() {
    let damping = 0.5;
    let errors = [1e5, 1e7, 1e9].map(|stiffness: f64| {
        let law = [PowerLaw::hertz(exact(stiffness))];
        let impact =
            enclose_lossy_impact(&fraction(3, 2), &fraction(323, 1000), &law, &exact(damping))
                .expect("a proof");
        let setup = Setup {
            stiffness,
            loss: Some(ContactLoss {
                law: LossyLaw::HuntCrossley,
                amount: LossAmount::Damping(damping),
            }),
            ..Setup::default()
        };
        let solved = solve(setup).expect("an impact");
        assert_losses_are_those_of_runge_kutta(&solved, &impact);
        let [(_, restitution), _] = impact.losses().expect("a loss");
        let scaled = damping * to_f64(&impact.speed.middle);
        let function = |z: f64| z - z.ln_1p();
        let lost = function(-scaled * to_f64(&restitution.middle)) / function(scaled) - 1.0;
        lost.abs()
    });
    // The part of the swing falls as the depth does, as gamma^(-2/5): by 6.3 each time.
    assert!(
        errors.windows(2).all(|pair| (0.14..0.18).contains(&(pair[1] / pair[0]))),
        "{errors:?}"
    );
    let negative = enclose_lossy_impact(
        &fraction(3, 2),
        &fraction(323, 1000),
        &[PowerLaw::hertz(fraction(1_000_000, 1))],
        &fraction(-1, 2),
    );
    assert_eq!(negative.expect_err("a gain"), NotEnclosed::Damping);
}

/// The harder a spring with a dashpot, the less the swing acts during the contact, whose restitution is then
/// `exp(-pi zeta/sqrt(1 - zeta^2))`, or without pull `exp(-2 b cot b)` with `zeta = cos b`; Runge-Kutta agrees at every
/// hardness.
#[test]
fn a_contact_with_a_dashpot_is_proved() {
    let (zeta, pi) = (0.2_f64, std::f64::consts::PI);
    let cotangent = zeta / (1.0 - zeta * zeta).sqrt();
    for (dashpot, alone) in [
        (Dashpot::Pulls, (-pi * cotangent).exp()),
        (Dashpot::DoesNotPull, (-2.0 * zeta.acos() * cotangent).exp()),
    ] {
        let errors = [1e4, 1e6, 1e8].map(|stiffness: f64| {
            let setup = Setup {
                stiffness,
                force: Some("gamma*d".parse().expect("a force")),
                loss: Some(ContactLoss {
                    law: LossyLaw::Dashpot(dashpot),
                    amount: LossAmount::Restitution(alone),
                }),
                ..Setup::default()
            };
            let solved = solve(setup).expect("an impact");
            assert!((solved.damping / (2.0 * zeta / stiffness.sqrt()) - 1.0).abs() < 1e-12);
            let numbers = [exact(stiffness), exact(solved.damping)];
            let impact = enclose_dashpot_impact(
                &fraction(3, 2),
                &fraction(323, 1000),
                &numbers[0],
                &numbers[1],
                dashpot == Dashpot::Pulls,
            )
            .expect("a proof");
            assert_losses_are_those_of_runge_kutta(&solved, &impact);
            let [(_, restitution), _] = impact.losses().expect("a loss");
            (to_f64(&restitution.middle) / alone - 1.0).abs()
        });
        // The part of the swing falls as the depth does, as gamma^(-1/2): by 10 each time.
        assert!(
            errors.windows(2).all(|pair| (0.08..0.12).contains(&(pair[1] / pair[0]))),
            "{dashpot:?}: {errors:?}"
        );
    }
    let (amplitude, barrier) = (fraction(3, 2), fraction(323, 1000));
    let stiffness = fraction(10_000, 1);
    let by_energy = PowerLaw { stiffness: stiffness.clone(), exponent: fraction(1, 1) };
    let by_energy = enclose_impact(&amplitude, &barrier, &[by_energy]).expect("a proof");
    for pulls in [true, false] {
        let none = fraction(0, 1);
        let by_motion = enclose_dashpot_impact(&amplitude, &barrier, &stiffness, &none, pulls);
        let by_motion =
            by_motion.expect("a proof").in_order().map(|(name, own)| (name, own.clone()));
        for ((name, one), (_, other)) in by_energy.in_order().into_iter().zip(by_motion) {
            let apart = to_f64(&(&one.middle - &other.middle).abs());
            assert!(apart <= one.radius.value() + other.radius.value(), "{name}: {apart}");
        }
    }
}

//! The series of a step of equation (7), in free flight by time, in contact by s.
//!
//! A left barrier is a right one seen in a mirror: x, v, beta and the direction of friction change
//! sign. (The recurrences: A. Jorba, M. Zou, *Experimental Mathematics* 14 (2005) 99.) A force is a
//! term in both functions and one in the equation of the test, which holds the series of both to
//! those of the equation, in contact regularised by `regularised`.

use super::kernels::{
    INVERSE, per_lane, product, quotient, sine_and_cosine, square, time, waves_of_time,
};
use super::series::{HIGHEST_ORDER, Inputs, SeriesCoefficients, Terms};
use super::stretch::{in_contact, in_flight, stretched, stretched_next};
use crate::impact::model::STEEPNESS;

/// The series of free motion to this order, by time.
///
/// ```text
/// x' = v
/// drive = sin(eta*t)
/// counter = cos(eta*t)
/// sine = sin(x)
/// cosine = cos(x)
/// slowing = atan(k*v)
/// force = -sine - viscous*v - dry - arctangent*slowing + beta*drive*cosine
/// v' = force
/// t' = 1
/// ```
#[inline(always)]
pub(super) fn flight<const L: usize>(
    inputs: &Inputs<L>,
    order: usize,
    terms: Terms,
    series: &mut SeriesCoefficients<L>,
) {
    let order = order.min(HIGHEST_ORDER);
    let stretch = in_flight(inputs);
    let SeriesCoefficients { place: x, velocity: v, time: t, scratch, ahead, ahead_of_waves } =
        series;
    let [drive, counter, x_slope, sine, cosine, scaled_v, slowing_over, slowing_slope, slowing, ..] =
        scratch;
    let [scaled_v_squared_ahead, drive_cosine_ahead, ..] = ahead;
    let [sine_ahead, ..] = ahead_of_waves;
    let mut force_before = [[0.0; L]; 2];
    x[0] = inputs.place;
    v[0] = inputs.velocity;
    t[0] = [0.0; L];
    time(t, &inputs.unit, &stretch);
    sine[0] = inputs.sine;
    cosine[0] = inputs.cosine;
    if terms.excited {
        drive[0] = inputs.drive[0];
        counter[0] = inputs.drive[1];
    }
    for n in 0..order {
        let factor: [f64; L] = per_lane(|lane| inputs.unit[lane] * INVERSE[n + 1]);
        let v_stretched = stretched(&stretch, v, n);
        x_slope[n] = per_lane(|lane| inputs.unit[lane] * v_stretched[lane]);
        x[n + 1] = per_lane(|lane| INVERSE[n + 1] * x_slope[n][lane]);
        if terms.excited && n > 0 {
            waves_of_time(
                [&mut *drive, &mut *counter],
                &stretch,
                &per_lane(|lane| inputs.unit[lane] * inputs.eta[lane] * INVERSE[n]),
                n,
            );
        }
        if n > 0 {
            sine_and_cosine([&mut *sine, &mut *cosine], x_slope, n, sine_ahead);
        }
        if terms.arctangent {
            scaled_v[n] = per_lane(|lane| STEEPNESS * v[n][lane]);
            let scaled_v_squared = square(scaled_v, n, scaled_v_squared_ahead);
            let mut slowing_over_n: [f64; L] = per_lane(|lane| scaled_v_squared[lane]);
            if n == 0 {
                slowing_over_n = per_lane(|lane| slowing_over_n[lane] + 1.0);
            }
            slowing_over[n] = slowing_over_n;
            if n == 0 {
                slowing[0] = per_lane(|lane| (scaled_v[0][lane]).atan());
            }
            if n > 0 {
                quotient(
                    [&mut *slowing, &mut *slowing_slope],
                    &per_lane(|lane| n as f64 * scaled_v[n][lane]),
                    slowing_over,
                    n,
                );
            }
        }
        let mut force: [f64; L] =
            per_lane(|lane| -sine[n][lane] - inputs.viscous[lane] * v[n][lane]);
        if n == 0 {
            force = per_lane(|lane| force[lane] - inputs.dry[lane]);
        }
        if terms.arctangent {
            force = per_lane(|lane| force[lane] - inputs.arctangent[lane] * slowing[n][lane]);
        }
        if terms.excited {
            let drive_cosine = product(drive, cosine, n, drive_cosine_ahead);
            force = per_lane(|lane| force[lane] + inputs.beta[lane] * drive_cosine[lane]);
        }
        let force_stretched = stretched_next(&stretch, force, &mut force_before);
        v[n + 1] = per_lane(|lane| factor[lane] * force_stretched[lane]);
    }
}

/// The series of motion in contact to this order, by s: x = x_r + w^2, dt = w ds.
///
/// ```text
/// t' = w
/// w' = v/2
/// depth = w^2
/// drive = sin(eta*t)
/// counter = cos(eta*t)
/// sine = sin(x_r + depth)
/// cosine = cos(x_r + depth)
/// fourth = depth^2
/// slowing = atan(k*v)
/// slow = sine + dry + arctangent*slowing - beta*drive*cosine
/// force = -w*slow - gamma*fourth - mu*v*fourth
/// (v + viscous*depth)' = force
/// ```
#[inline(always)]
pub(super) fn contact<const L: usize>(
    inputs: &Inputs<L>,
    order: usize,
    terms: Terms,
    series: &mut SeriesCoefficients<L>,
) {
    let order = order.min(HIGHEST_ORDER);
    let stretch = in_contact(inputs);
    let SeriesCoefficients { place: w, velocity: v, time: t, scratch, ahead, ahead_of_waves } =
        series;
    let [
        depth,
        t_slope,
        drive,
        counter,
        depth_slope,
        sine,
        cosine,
        fourth,
        scaled_v,
        slowing_over,
        slowing_slope,
        slowing,
        slow,
        ..,
    ] = scratch;
    let [
        depth_ahead,
        fourth_ahead,
        scaled_v_squared_ahead,
        drive_cosine_ahead,
        w_slow_ahead,
        v_fourth_ahead,
        ..,
    ] = ahead;
    let [drive_ahead, sine_ahead, ..] = ahead_of_waves;
    let mut force_before = [[0.0; L]; 2];
    w[0] = inputs.place;
    v[0] = inputs.velocity;
    t[0] = [0.0; L];
    sine[0] = inputs.sine;
    cosine[0] = inputs.cosine;
    if terms.excited {
        drive[0] = inputs.drive[0];
        counter[0] = inputs.drive[1];
    }
    depth[0] = square(w, 0, depth_ahead);
    for n in 0..order {
        let factor: [f64; L] = per_lane(|lane| inputs.unit[lane] * INVERSE[n + 1]);
        let w_stretched = stretched(&stretch, w, n);
        t[n + 1] = per_lane(|lane| factor[lane] * w_stretched[lane]);
        let v_stretched = stretched(&stretch, v, n);
        w[n + 1] = per_lane(|lane| 0.5 * factor[lane] * v_stretched[lane]);
        depth[n + 1] = square(w, n + 1, depth_ahead);
        depth_slope[n] = per_lane(|lane| (n + 1) as f64 * depth[n + 1][lane]);
        if terms.excited && n > 0 {
            t_slope[n - 1] = per_lane(|lane| n as f64 * inputs.eta[lane] * t[n][lane]);
            sine_and_cosine([&mut *drive, &mut *counter], t_slope, n, drive_ahead);
        }
        if n > 0 {
            sine_and_cosine([&mut *sine, &mut *cosine], depth_slope, n, sine_ahead);
        }
        fourth[n] = square(depth, n, fourth_ahead);
        if terms.arctangent {
            scaled_v[n] = per_lane(|lane| STEEPNESS * v[n][lane]);
            let scaled_v_squared = square(scaled_v, n, scaled_v_squared_ahead);
            let mut slowing_over_n: [f64; L] = per_lane(|lane| scaled_v_squared[lane]);
            if n == 0 {
                slowing_over_n = per_lane(|lane| slowing_over_n[lane] + 1.0);
            }
            slowing_over[n] = slowing_over_n;
            if n == 0 {
                slowing[0] = per_lane(|lane| (scaled_v[0][lane]).atan());
            }
            if n > 0 {
                quotient(
                    [&mut *slowing, &mut *slowing_slope],
                    &per_lane(|lane| n as f64 * scaled_v[n][lane]),
                    slowing_over,
                    n,
                );
            }
        }
        let mut slow_n: [f64; L] = per_lane(|lane| sine[n][lane]);
        if n == 0 {
            slow_n = per_lane(|lane| slow_n[lane] + inputs.dry[lane]);
        }
        if terms.arctangent {
            slow_n = per_lane(|lane| slow_n[lane] + inputs.arctangent[lane] * slowing[n][lane]);
        }
        if terms.excited {
            let drive_cosine = product(drive, cosine, n, drive_cosine_ahead);
            slow_n = per_lane(|lane| slow_n[lane] - inputs.beta[lane] * drive_cosine[lane]);
        }
        slow[n] = slow_n;
        let w_slow = product(w, slow, n, w_slow_ahead);
        let mut force: [f64; L] =
            per_lane(|lane| -inputs.gamma[lane] * fourth[n][lane] - w_slow[lane]);
        if terms.damped_contact {
            let v_fourth = product(v, fourth, n, v_fourth_ahead);
            force = per_lane(|lane| force[lane] - inputs.mu[lane] * v_fourth[lane]);
        }
        let force_stretched = stretched_next(&stretch, force, &mut force_before);
        v[n + 1] = per_lane(|lane| {
            factor[lane] * force_stretched[lane] - inputs.viscous[lane] * depth[n + 1][lane]
        });
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::super::series::{LaneSeries, TIME_TERMS};
    use super::*;
    use crate::expr::{Expr, parse_expression};
    use crate::impact::model::Side;
    use crate::impact::regularised::regularised;
    use crate::series::recurrence::Recurrences;
    use crate::symbol::Symbol;

    /// Equation (7) as it stands on paper; P is the force of the barrier.
    const EQUATION: &str =
        "P - sin(x) - viscous*x' - dry - arctangent*atan(k*x') + beta*sin(eta*t)*cos(x)";

    const ORDER: usize = 24;

    /// A start with every force on, which the terms of a test switch off.
    fn inputs(terms: Terms) -> Inputs<1> {
        let on = |on: bool, value: f64| [if on { value } else { 0.0 }];
        let angle = 0.4_f64 + 0.3 * 0.3;
        let (sine, cosine) = (1.3_f64 * 0.7).sin_cos();
        Inputs {
            place: [0.3],
            velocity: [0.02],
            sine: [angle.sin()],
            cosine: [angle.cos()],
            drive: [[sine], [cosine]],
            unit: [0.01],
            hertz: [[0.35], [30.0]],
            dry: [0.05],
            arctangent: on(terms.arctangent, 0.11),
            viscous: [0.2],
            beta: on(terms.excited, 0.6),
            eta: [1.3],
            gamma: [500.0],
            mu: on(terms.damped_contact, 70.0),
            ..Inputs::new()
        }
    }

    /// The series of a system of equations by the recurrences of their expressions, state by state,
    /// in the stretched variable of a step.
    fn by_expressions(
        states: [(&str, f64); 3],
        rates: &[Expr],
        (inputs, [[p], [q]]): (&Inputs<1>, [[f64; 1]; 2]),
    ) -> Vec<Vec<f64>> {
        let number = |name: &str, value: [f64; 1]| (Symbol::from(name), value[0]);
        let numbers = BTreeMap::from([
            number("dry", inputs.dry),
            number("arctangent", inputs.arctangent),
            number("viscous", inputs.viscous),
            number("beta", inputs.beta),
            number("eta", inputs.eta),
            number("gamma", inputs.gamma),
            number("mu", inputs.mu),
            number("x_c", [0.4]),
            number("k", [STEEPNESS]),
            number("unit", inputs.unit),
            number("p", [p]),
            number("q", [q]),
        ]);
        let text = |text: &str| parse_expression(text).expect(text);
        let stretch = text("unit*(1 + p*r + q*r^2)");
        let states = states.into_iter().chain([("r", 0.0)]);
        let variables: Vec<(Symbol, Option<usize>)> =
            states.clone().map(|(name, _)| (Symbol::from(name), None)).collect();
        let mut recurrences = Recurrences::new(&variables, &numbers, ORDER);
        let rates = rates.iter().map(|rate| &stretch * rate).chain([Expr::one()]);
        let rates: Vec<usize> =
            rates.map(|rate| recurrences.add(&rate).expect("recurrences")).collect();
        let mut tape = recurrences.into_tape();
        for (place, (_, value)) in states.enumerate() {
            tape.set(place, 0, value);
        }
        tape.expand(&rates);
        (0..rates.len()).map(|place| tape.series(place).to_vec()).collect()
    }

    fn assert_same(own: &LaneSeries<1>, other: &[f64], what: &str) {
        let size = other.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        for (n, (own, other)) in own.iter().zip(other).enumerate() {
            assert!(
                (own[0] - other).abs() <= 1e-13 * (other.abs() + 1e-3 * size),
                "{what}, order {n}: {} and {other}",
                own[0]
            );
        }
    }

    /// The recurrences of this file are compared with the series of equation (7) as an expression,
    /// coefficient by coefficient.
    #[test]
    fn the_series_are_those_of_the_equation() {
        let acceleration = parse_expression(EQUATION).expect("equation (7)");
        let in_contact_rates =
            regularised(&[acceleration.clone(), Expr::one()], Side::Right).expect("rates in s");
        let free = acceleration.substitute("P".into(), &Expr::zero()).expect("no barrier");
        let in_flight_rates = [Expr::symbol("x'"), free, Expr::one()];
        for bits in 0..8 {
            let terms = Terms {
                arctangent: bits & 1 != 0,
                excited: bits & 2 != 0,
                damped_contact: bits & 4 != 0,
            };
            let mut now = inputs(terms);
            let mut series = SeriesCoefficients::<1>::new();
            contact(&now, ORDER, terms, &mut series);
            let start = [("w", 0.3), ("x'", 0.02), ("t", 0.7)];
            let other = by_expressions(start, &in_contact_rates, (&now, in_contact(&now)));
            assert_same(&series.place, &other[0], "w");
            assert_same(&series.velocity, &other[1], "v in contact");
            assert_same(&series.time, &[&[0.0], &other[2][1..]].concat(), "t");
            let x = 0.4 + 0.3 * 0.3;
            now.place = [x];
            flight(&now, ORDER, terms, &mut series);
            let start = [("x", x), ("x'", 0.02), ("t", 0.7)];
            let other = by_expressions(start, &in_flight_rates, (&now, in_flight(&now)));
            assert_same(&series.time, &[&[0.0], &other[2][1..TIME_TERMS]].concat(), "t in flight");
            assert_same(&series.place, &other[0], "x");
            assert_same(&series.velocity, &other[1], "v in flight");
        }
    }
}

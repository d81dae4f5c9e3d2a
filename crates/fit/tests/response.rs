//! Frequency responses made by another integrator than that of the fit, swept up and down through their folds, and fitted.

use std::f64::consts::TAU;

use lindstedt_fit::fit::laws::Law;
use lindstedt_fit::fit::response::{FrequencyResponse, ResponseError, ResponseRow, fit_response};
use lindstedt_fit::numeric::ode::{IntegrationOptions, State, integrate};
use lindstedt_fit::symbol::Symbol;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Amplitudes and phases of the first harmonic along a sweep, each frequency from where the one before ended.
fn sweep(
    force: impl Fn(f64, f64) -> f64 + Copy,
    drive: f64,
    frequencies: &[f64],
) -> Vec<ResponseRow> {
    const PERIODS: f64 = 80.0;
    let options = IntegrationOptions::with_tolerance(1e-9);
    let (mut x, mut v) = (0.0, 0.0);
    let row = |frequency: &f64| {
        let acceleration = |t: f64, x: f64, v: f64| drive * (frequency * t).cos() - force(x, v);
        let period = TAU / frequency;
        let settled = PERIODS * period;
        let state = State { t: 0.0, x, v };
        let path = integrate(acceleration, state, settled + period, &[], &options).unwrap();
        let count = 400;
        let (mut cosine, mut sine) = (0.0, 0.0);
        for index in 0..count {
            let angle = TAU * f64::from(index) / f64::from(count);
            let (x, _) = path.phase_point_at(settled + angle / frequency).unwrap();
            cosine += 2.0 / f64::from(count) * x * angle.cos();
            sine += 2.0 / f64::from(count) * x * angle.sin();
        }
        (x, v) = (path.end().x, path.end().v);
        let phase = Some(sine.atan2(cosine));
        ResponseRow { frequency: *frequency, amplitude: cosine.hypot(sine), phase }
    };
    frequencies.iter().map(row).collect()
}

/// Frequencies from one to the other.
fn range(from: f64, to: f64, count: u32) -> Vec<f64> {
    let step = (to - from) / f64::from(count - 1);
    (0..count).map(|index| from + step * f64::from(index)).collect()
}

fn normal(generator: &mut ChaCha8Rng) -> f64 {
    let radius = (-2.0 * (1.0 - generator.random::<f64>()).ln()).sqrt();
    radius * (TAU * generator.random::<f64>()).cos()
}

/// The rows with noise of these sizes of amplitude and phase; without phases if theirs is `None`.
fn noisy(rows: &[ResponseRow], seed: u64, noise: f64, of_phase: Option<f64>) -> Vec<ResponseRow> {
    let generator = &mut ChaCha8Rng::seed_from_u64(seed);
    let row = |row: &ResponseRow| {
        let amplitude = row.amplitude + noise * normal(generator);
        let off = of_phase.map(|noise| noise * normal(generator));
        ResponseRow { amplitude, phase: row.phase.zip(off).map(|(own, off)| own + off), ..*row }
    };
    rows.iter().map(row).collect()
}

/// The Duffing oscillator `x'' + 0.1 x' + x + 0.5 x^3 = F cos(Omega t)`, both branches between its folds among the rows.
fn duffing(drive: f64) -> Vec<ResponseRow> {
    let force = |x: f64, v: f64| 0.1 * v + x + 0.5 * x.powi(3);
    let up = sweep(force, drive, &range(0.6, 1.44, 22));
    let down = sweep(force, drive, &range(2.0, 1.4, 13));
    // The sweeps are on different branches where they meet.
    assert!(drive < 0.2 || up[21].amplitude > 2.0 * down[12].amplitude);
    [up, down].concat()
}

fn is_true(fit: &lindstedt_fit::fit::response::ResponseFit, truth: &[(&str, f64)], words: &str) {
    assert!(fit.converged, "{words}");
    for (name, value) in truth {
        let own = fit.estimates.iter().find(|own| own.name == *name).unwrap();
        assert!((own.value - value).abs() < 3.5 * own.error, "{words}: {own:?} {value}");
        assert!(own.error < 0.05 * value.abs(), "{words}: {own:?}");
    }
}

#[test]
fn a_duffing_oscillator_is_found_from_a_response_with_a_fold() {
    let law = Law::parse("x'' + c*x' + k*x + b*x^3 = F*cos(Omega*t)").unwrap();
    let truth = [("c", 0.1), ("k", 1.0), ("b", 0.5), ("F", 0.3)];
    const NOISE: f64 = 1e-3;
    let exact = duffing(0.3);
    let mut square = 0.0;
    let mut count = 0.0;
    for seed in 0..3 {
        for of_phase in [None, Some(2e-3)] {
            let rows = noisy(&exact, seed, NOISE, of_phase);
            let fit = fit_response(&law, &FrequencyResponse { rows, known: vec![] }, None).unwrap();
            is_true(&fit, &truth, &format!("seed {seed} {of_phase:?}"));
            assert!((fit.noise / NOISE - 1.0).abs() < 0.4, "{}", fit.noise);
            for (name, value) in truth {
                let own = fit.estimates.iter().find(|own| own.name == name).unwrap();
                square += ((own.value - value) / own.error).powi(2);
                count += 1.0;
            }
        }
    }
    // The standard errors are of the size of the errors: their ratio has a spread of one.
    let spread = f64::sqrt(square / count);
    assert!((0.6..1.5).contains(&spread), "{spread}");
}

#[test]
fn several_levels_of_a_known_drive_are_fitted_together() {
    let law = Law::parse("x'' + c*x' + k*x + b*x^3 = F*cos(Omega*t)").unwrap();
    let rows = |drive: f64, seed: u64| noisy(&duffing(drive), seed, 2e-3, None);
    let [large, small] = [rows(0.3, 7), rows(0.1, 8)];
    let drives = [vec![0.3; large.len()], vec![0.1; small.len()]].concat();
    let known = vec![(Symbol::new("F"), drives)];
    let fit = fit_response(&law, &FrequencyResponse { rows: [large, small].concat(), known }, None)
        .unwrap();
    assert_eq!(fit.estimates.len(), 3);
    is_true(&fit, &[("c", 0.1), ("k", 1.0), ("b", 0.5)], "two levels");
}

#[test]
fn mistakes_of_responses_are_named() {
    let rows = |count: u32| {
        let row = |frequency: f64| ResponseRow { frequency, amplitude: 1.0, phase: None };
        FrequencyResponse {
            rows: range(0.5, 2.0, count).into_iter().map(row).collect(),
            known: vec![],
        }
    };
    let law = |text: &str| Law::parse(text).unwrap();
    let free = law("x'' + c*x' + k*x = 0");
    assert!(matches!(fit_response(&free, &rows(9), None).unwrap_err(), ResponseError::NoDrive(_)));
    let driven = law("x'' + c*x' + k*x = F*cos(Omega*t)");
    let few = ResponseError::TooFew { found: 4, needed: 5 };
    assert_eq!(fit_response(&driven, &rows(4), None).unwrap_err(), few);
    let mut wrong = rows(9);
    wrong.rows[3].amplitude = f64::NAN;
    let error = fit_response(&driven, &wrong, None).unwrap_err();
    assert_eq!(error, ResponseError::NotPositive(4));
}

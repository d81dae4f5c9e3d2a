//! The judge's numbers: the true frequency, errors and verdicts, the deviation of the motion, and
//! the range within the tolerance, each against the test's own.

use std::f64::consts::TAU;

use lindstedt::Oscillator;
use lindstedt::Values;
use lindstedt::solution::Method;
use lindstedt::verify::AmplitudeReach;
use lindstedt::verify::Verdict;
use lindstedt::verify::comparison::{Comparison as Table, ComparisonRow, compare};

use super::Comparison;
use super::definitions::{Answer, Question};

const TOLERANCE: f64 = 0.01;

/// Amplitudes at which a range is looked at.
const PLACES: usize = 60;

/// What is wrong with the table of all methods at `at`, whose lengths and frequencies are in these
/// units.
pub fn judgement(
    question: &Question,
    oscillator: &Oscillator,
    at: &Values,
    units: (f64, f64),
) -> Vec<Comparison> {
    let truth = question.truth();
    let (squared, noise) = match truth {
        Answer::Value(squared, noise) => (squared, noise),
        _ => return vec![],
    };
    let report = |method, complaint| Comparison { method, complaint };
    let table = match compare(oscillator, at, None, TOLERANCE) {
        Ok(table) => table,
        Err(error) => {
            let text: String = error.to_string().chars().take(150).collect();
            return vec![report("judge", Some(format!("compare fails: {text}")))];
        }
    };
    let Some(true_frequency) = table.true_frequency else {
        return vec![report(
            "judge",
            table.reason.map(|reason| format!("no true motion: {reason}")),
        )];
    };
    let found = (true_frequency / units.1).powi(2);
    let wrong = (found / squared - 1.0).abs() > 1e-8 + noise;
    let complaint =
        wrong.then(|| format!("true omega^2 = {found}, not {squared} (good to {noise:.0e})"));
    let mut list = vec![report("judge", complaint), report("verdicts", verdicts(&table))];
    if wrong {
        return list;
    }
    if let Some(motion) = motion(question, squared.sqrt()) {
        list.push(report("deviation", deviations(question, &table, &motion, units)));
    }
    list.push(report("range", table.rows.iter().find_map(|row| range(question, row, units.0))));
    list
}

/// Errors and verdicts that do not follow from the frequencies beside them.
fn verdicts(table: &Table) -> Option<String> {
    let wrong = |row: &&ComparisonRow| {
        let error = row
            .frequency
            .zip(table.true_frequency)
            .map(|(frequency, truth)| frequency / truth - 1.0);
        let pass = error.is_some_and(|error| error.abs() <= TOLERANCE);
        row.relative_error != error || (row.verdict == Some(Verdict::Pass)) != pass
    };
    table
        .rows
        .iter()
        .find(wrong)
        .map(|row| format!("{}: {:?} {:?}", row.solution.title(), row.relative_error, row.verdict))
}

/// The true motion over a period at equal steps of time, by the classical Runge-Kutta rule; `None`
/// where its energy drifts.
fn motion(question: &Question, frequency: f64) -> Option<Vec<f64>> {
    const STEPS: usize = 8192;
    let step = TAU / frequency / STEPS as f64;
    let pull = |y: f64| -question.f(y);
    let (mut y, mut v) = (question.amplitude, 0.0);
    let mut path = vec![y];
    for _ in 0..STEPS {
        let (y1, v1) = (v, pull(y));
        let (y2, v2) = (v + 0.5 * step * v1, pull(y + 0.5 * step * y1));
        let (y3, v3) = (v + 0.5 * step * v2, pull(y + 0.5 * step * y2));
        let (y4, v4) = (v + step * v3, pull(y + step * y3));
        y += step / 6.0 * (y1 + 2.0 * y2 + 2.0 * y3 + y4);
        v += step / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
        path.push(y);
    }
    let back = (y - question.amplitude).abs() + v.abs() / frequency;
    (back < 1e-7 * question.amplitude.abs()).then_some(path)
}

/// The largest deviation of `A cos(omega t)`.
fn deviations(
    question: &Question,
    table: &Table,
    path: &[f64],
    units: (f64, f64),
) -> Option<String> {
    let truth = table.true_frequency? / units.1;
    let one_term = table.rows.iter().filter(|row| {
        matches!(
            row.solution.method,
            Method::Hamiltonian
                | Method::EnergyBalance
                | Method::AmplitudeFrequency
                | Method::FrequencyFormula
        )
    });
    one_term.filter_map(|row| Some((row, row.frequency? / units.1, row.max_deviation?))).find_map(
        |(row, frequency, found)| {
            let at = |k: usize| TAU / truth * k as f64 / (path.len() - 1) as f64;
            let formula = |k: usize| question.amplitude * (frequency * at(k)).cos();
            let largest = (0..path.len()).map(|k| (path[k] - formula(k)).abs()).fold(0.0, f64::max);
            let expected = largest / question.amplitude.abs();
            let wrong = (found - expected).abs() > 1e-3 * expected + 1e-7;
            wrong.then(|| format!("{}: deviation {found}, not {expected}", row.solution.title()))
        },
    )
}

/// A range that skips a failure, or ends before one.
fn range(question: &Question, row: &ComparisonRow, unit: f64) -> Option<String> {
    let definition = |question: &Question| match row.solution.method {
        Method::Hamiltonian | Method::VariationalIteration | Method::MaxMin => {
            question.shared_integral()
        }
        Method::EnergyBalance => question.energy_balance(),
        Method::AmplitudeFrequency => question.amplitude_frequency(),
        Method::FrequencyFormula => question.frequency_formula(),
        Method::LindstedtPoincare if row.solution.parameters.is_empty() => {
            question.lindstedt_poincare(4)
        }
        Method::Pade if row.solution.parameters.is_empty() => question.pade(2, 1, None),
        _ => Answer::Unknown,
    };
    let good = |size: f64| {
        let there = Question { amplitude: size.copysign(question.amplitude), ..*question };
        match (there.truth(), definition(&there)) {
            (Answer::Value(truth, _), Answer::Value(found, noise)) if noise < 1e-6 => {
                Some((found / truth).max(0.0).sqrt() - 1.0)
            }
            (Answer::Value(..), Answer::Nothing(_)) => Some(-1.0),
            _ => None,
        }
    };
    let title = row.solution.title();
    let (end, last) = match row.reach? {
        // These families swing about bottoms.
        AmplitudeReach::Between { .. } => {
            return Some("a range that does not begin at rest".to_owned());
        }
        AmplitudeReach::Everywhere(searched) => (searched / unit, true),
        AmplitudeReach::UpTo(end) => (end / unit, false),
        AmplitudeReach::Nowhere => {
            let small = 1e-3 * question.amplitude.abs();
            let error = good(small).filter(|error| error.abs() < 0.5 * TOLERANCE)?;
            return Some(format!(
                "{title}: within 1 % nowhere, but the error is {error:.2e} at A = {}",
                small * unit
            ));
        }
    };
    let place = |k: usize| end * 0.999 * k as f64 / PLACES as f64;
    for size in (1..=PLACES).map(place) {
        if let Some(error) = good(size).filter(|error| error.abs() > TOLERANCE * 1.001) {
            let (size, end) = (size * unit, end * unit);
            return Some(format!(
                "{title}: within 1 % up to A = {end}, but the error is {error:.3e} at A = {size}"
            ));
        }
    }
    let beyond = (1..=20).map(|k| good(end * (1.0 + 0.002 * f64::from(k))));
    let errors: Option<Vec<f64>> = beyond.collect();
    let below = |error: &f64| error.abs() < 0.99 * TOLERANCE;
    // A pole of the law may spoil next to nothing, so that coarse steps pass over it.
    let close_by = || {
        let offsets = std::iter::successors(Some(1e-7), |offset| Some(1.03 * offset))
            .take_while(|offset| *offset < 1e-2);
        let mut errors = offsets.filter_map(|offset| good(end * (1.0 + offset)));
        errors.all(|error| below(&error))
    };
    let early = !last && errors.is_some_and(|errors| errors.iter().all(below)) && close_by();
    early.then(|| {
        format!(
            "{title}: the range ends at A = {}, but the error stays below 1 % beyond",
            end * unit
        )
    })
}

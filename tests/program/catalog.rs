//! Every classical oscillator: its equation, its methods, its published law, its motion.

use std::collections::BTreeSet;

use lindstedt::catalog::{CATALOG, CatalogEntry, find, methods};
use lindstedt::coupled::CoupledEquations;
use lindstedt::exact::Polynomial;
use lindstedt::expr::parse_expression;
use lindstedt::method::{Options, solve};
use lindstedt::modes::{FreeSystem, ModeOptions, derive};
use lindstedt::solution::{AmplitudeConvention, Method};
use lindstedt::verify::{Verdict, judge, judge_mode, needed_values};
use lindstedt::{Interrupt, Values};
use lindstedt::{Oscillator, Solution};

#[test]
fn names_are_unique_and_lead_back() {
    let names: BTreeSet<&str> = CATALOG.iter().map(|entry| entry.name).collect();
    assert_eq!(names.len(), CATALOG.len());
    assert!(CATALOG.len() >= 16);
    for entry in CATALOG {
        assert_eq!(find(entry.name), Some(entry));
        match entry.is_coupled() {
            true => assert!(CoupledEquations::parse(entry.equation).is_ok(), "{}", entry.name),
            false => assert!(Oscillator::parse(entry.equation).is_ok(), "{}", entry.name),
        }
    }
}

/// The entries of one coordinate.
fn of_one_coordinate() -> impl Iterator<Item = &'static CatalogEntry> {
    CATALOG.iter().filter(|entry| !entry.is_coupled() && entry.walls.is_empty())
}

/// The modes that coupled entries have are the true ones at small amplitudes, and the error of each law
/// falls with the first power of the amplitude that it leaves out.
#[test]
fn modes_of_coupled_entries_are_the_true_ones() {
    let without_walls = CATALOG.iter().filter(|entry| entry.walls.is_empty());
    let coupled: Vec<&CatalogEntry> = without_walls.filter(|entry| entry.is_coupled()).collect();
    assert!(coupled.len() >= 12);
    let mut modes = 0;
    for entry in coupled {
        let methods = methods(entry);
        assert!(methods.iter().any(|(_, answer)| answer.is_ok()), "{} has no method", entry.name);
        let Ok(system) = FreeSystem::parse(entry.equation) else {
            continue;
        };
        let options = ModeOptions { order: Some(2), ..ModeOptions::default() };
        let Ok(found) = derive(&system, &options) else {
            continue;
        };
        for mode in found.modes.iter().flatten() {
            let mut at = Values::default();
            at.insert(mode.amplitude.symbol(), "1/10".parse().expect("a number")).expect("a value");
            for name in &system.equations.parameters {
                // The frequencies of the elastic pendulum are apart at W = 3/2.
                let value = if name.name() == "W" { "3/2" } else { "1/2" };
                at.insert(*name, value.parse().expect("a number")).expect("a value");
            }
            let judged = judge_mode(&system, mode, &at, 1e-3, Interrupt::default())
                .unwrap_or_else(|error| panic!("{} {}: {error}", entry.name, mode.number));
            let context = format!("{} {}: {judged:?}", entry.name, mode.number);
            assert_eq!(judged.verdict, Verdict::Pass, "{context}");
            assert!(judged.slope.is_none_or(|slope| slope > 3.5), "{context}");
            modes += 1;
        }
    }
    assert!(modes >= 15, "{modes} modes");
}

#[test]
fn every_method_answers_or_says_why_not() {
    let mut answers = 0;
    for entry in CATALOG {
        for (method, result) in methods(entry) {
            match result {
                Ok(()) => answers += 1,
                Err(refusal) => {
                    assert!(refusal.len() > 20, "{} {}", entry.name, method.name())
                }
            }
        }
    }
    assert!(answers >= 24, "{answers} answers");
}

/// The listing has a line for each oscillator. Of one alone the names of methods fill their lines:
/// none is longer than a hundred characters and a comma, and none is broken too early.
#[test]
fn the_listing_fills_its_lines() {
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .arg("catalog")
        .output()
        .expect("the program runs");
    let listing = String::from_utf8(output.stdout).expect("text");
    assert_eq!(listing.lines().count(), CATALOG.len());
    let mut broken = 0;
    for (entry, line) in CATALOG.iter().zip(listing.lines()) {
        assert!(line.starts_with(entry.name) && line.ends_with(entry.title), "{line}");
        let text = lindstedt::export::catalog::text(std::slice::from_ref(entry));
        assert!(text.starts_with(&format!("{}: {}\n", entry.name, entry.title)), "{text}");
        let lines: Vec<&str> = text.lines().collect();
        for pair in lines.windows(2).filter(|pair| pair[0].ends_with(',')) {
            let next = pair[1].trim_start().split([',', ':']).next().expect("a name");
            assert!(pair[0].len() <= 101 && pair[1].starts_with("    "), "{pair:?}");
            assert!(pair[0].len() + " ".len() + next.len() > 100, "{pair:?}");
            broken += 1;
        }
    }
    assert!(broken > CATALOG.len() / 2, "{broken}");
}

#[test]
fn derived_laws_are_the_published_ones() {
    let mut compared = 0;
    for entry in of_one_coordinate() {
        let Some(published) = entry.published else {
            continue;
        };
        let oscillator = Oscillator::parse(entry.equation).expect(entry.name);
        let amplitude = Some(AmplitudeConvention::Initial);
        let options = Options { order: Some(published.order), amplitude, ..Options::default() };
        let solution = solve(&oscillator, &options).expect(entry.name);
        let law = if published.squared {
            solution.law.frequency_squared()
        } else {
            solution.law.frequency()
        };
        let expected =
            parse_expression(published.law).expect(entry.name).to_polynomial(&mut |_| None);
        let expected: Option<Polynomial> = expected.expect("short");
        assert_eq!(law, expected.as_ref(), "{}", entry.name);
        compared += 1;
    }
    assert!(compared >= 12, "{compared} published laws");
}

/// The methods that expand in a small parameter; the others are held to their own claims in
/// `tests/conformance/`.
const EXPANSIONS: [Method; 2] = [Method::LindstedtPoincare, Method::HomotopyPerturbation];

#[test]
fn derived_motions_are_the_true_ones_at_small_amplitudes() {
    for entry in of_one_coordinate() {
        let oscillator = Oscillator::parse(entry.equation).expect(entry.name);
        for method in EXPANSIONS {
            let options = Options { method: Some(method), ..Options::default() };
            let Ok(solution) = solve(&oscillator, &options) else {
                continue;
            };
            let mut at = Values::default();
            for name in needed_values(&solution) {
                // Small amplitudes and parameters; those of the shape may be of order one.
                let value = match name.name() {
                    "A" | "a" => "1/20",
                    // A wire bears no more than 1/4.
                    "eps" | "mu" | "lambda" => "1/10",
                    _ => "1/2",
                };
                at.insert(name, value.parse().expect("a number")).expect("a value");
            }
            let verdict = judge(&oscillator, &solution, &at, 1e-3)
                .unwrap_or_else(|error| panic!("{}: {error}", entry.name));
            assert_eq!(
                verdict.verdict,
                Verdict::Pass,
                "{} by {}: {verdict:?}",
                entry.name,
                method.name()
            );
            assert!(
                verdict.max_deviation.is_some_and(|deviation| deviation < 5e-3),
                "{} {verdict:?}",
                entry.name
            );
        }
    }
}

/// The values at which an entry is judged: `size` for what makes the motion nonlinear, one half for
/// the rest.
fn values(solution: &Solution, size: &str) -> Values {
    let mut at = Values::default();
    for name in needed_values(solution) {
        let value = match name.name() {
            "A" | "a" | "mu" => size,
            "lambda" => "1/10",
            _ => "1/2",
        };
        at.insert(name, value.parse().expect("a number")).expect("a value");
    }
    at
}

/// A tolerance alone cannot tell a law from the linear frequency where the two are close: what
/// counts is how much of the true shift of the frequency, from almost linear to the amplitude in
/// question, the law misses. A coefficient of the leading correction that is twice too large misses
/// all of it.
#[test]
fn derived_laws_follow_the_shift_of_the_frequency() {
    let mut shifts = 0;
    for entry in of_one_coordinate() {
        let oscillator = Oscillator::parse(entry.equation).expect(entry.name);
        for method in EXPANSIONS {
            let options = Options { method: Some(method), ..Options::default() };
            let Ok(solution) = solve(&oscillator, &options) else {
                continue;
            };
            let judged = |size| {
                judge(&oscillator, &solution, &values(&solution, size), 1e-3).expect(entry.name)
            };
            // Where the leading shift nearly cancels, as that of a bubble, the next terms soon exceed it.
            let sizes =
                if entry.name == "bubble" { ["1/10000", "1/200"] } else { ["1/1000", "1/20"] };
            let [linear, nonlinear] = sizes.map(judged);
            let shift = (nonlinear.true_frequency / linear.true_frequency - 1.0).abs();
            let missed = nonlinear.relative_error.expect("a real frequency").abs();
            assert!(shift > 1e-7, "{} does not shift: {shift:e}", entry.name);
            let context = format!("{} by {}", entry.name, method.name());
            assert!(missed < shift / 8.0, "{context} misses {missed:e} of {shift:e}");
            shifts += 1;
        }
    }
    assert!(shifts >= 24, "{shifts} laws");
}

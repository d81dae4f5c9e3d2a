//! The condition of the max-min approach, decided at given numbers: whether `f(x)/x` stays between
//! its values at rest and at the turning point, and its least and largest value if it does not.
//!
//! By the comparison theorem of C. Sturm the true omega^2 of an odd force lies between the least
//! and the largest of `f(x)/x` over `0 < x <= A`, whatever its course between them (E. A.
//! Coddington, N. Levinson, *Theory of Ordinary Differential Equations*, McGraw-Hill 1955, chapter
//! 8).

use std::collections::BTreeMap;

use super::force_of;
use super::validity::Range;
use crate::conservative::force::CentredForce;
use crate::decimal::significant;
use crate::numeric::ode::root::find_root;
use crate::oscillator::Oscillator;
use crate::solution::{Method, Solution};
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FREQUENCY};

/// The relative change of `f/x` that counts: a smaller one may be rounding.
const VISIBLE: f64 = 1e-12;

/// Checks the bounds of the max-min approach at these numbers; the range is outside if they are not
/// those at rest and at `x = A`.
pub(super) fn bounds(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<Range> {
    if solution.method != Method::MaxMin {
        return None;
    }
    let amplitude = numbers.get(&solution.amplitude.symbol())?.abs();
    let force = force_of(oscillator, solution, numbers)?;
    let course = course(&force, amplitude)?;
    let (rest, end) = (course[0].1, course[course.len() - 1].1);
    let of = |choose: fn(f64, f64) -> f64| course.iter().map(|point| point.1).fold(rest, choose);
    let (least, largest) = (of(f64::min), of(f64::max));
    let number = |value: f64| significant(value, 6);
    // The force is that about the equilibrium.
    let (x, quotient) = match force.equilibrium() {
        0.0 => {
            let x = oscillator.coordinate.to_string();
            (x.clone(), format!("f({x})/{x}"))
        }
        place => {
            let x = format!("{} - {}", oscillator.coordinate, number(place)).replace("- -", "+ ");
            (x.clone(), format!("f/({x})"))
        }
    };
    let beyond = |value: f64, end: f64| (value - end).abs() > 1e-9 * largest.abs().max(least.abs());
    let outside = beyond(least, rest.min(end)) || beyond(largest, rest.max(end));
    let way = match rest < end {
        true => "rises",
        false => "falls",
    };
    let turn = first_extremum(&course);
    let text = match (turn, outside) {
        _ if !beyond(largest, least) => format!(
            "{quotient} is {} at every {x} up to {AMPLITUDE}: {FREQUENCY}^2 is that",
            number(end)
        ),
        (None, _) => format!(
            "{quotient} {way} all the way from {} at rest to {} at {x} = {AMPLITUDE}: {FREQUENCY}^2 lies between them",
            number(rest),
            number(end)
        ),
        (Some(place), false) => format!(
            "{quotient} turns back at {x} = {} but stays between {} at rest and {} at {x} = {AMPLITUDE}: {FREQUENCY}^2 lies between them",
            number(place),
            number(rest),
            number(end)
        ),
        (Some(place), true) => format!(
            "{quotient} turns back at {x} = {}, before {AMPLITUDE}: {FREQUENCY}^2 lies between its least and its largest value up to {AMPLITUDE}, {} and {}",
            number(place),
            number(least),
            number(largest)
        ),
    };
    Some(Range { text, outside })
}

/// `x` and `f(x)/x` from rest to the amplitude, at all places where it may turn back; `None` if it
/// has no value.
fn course(force: &CentredForce, amplitude: f64) -> Option<Vec<(f64, f64)>> {
    const LINEAR: i32 = 512;
    /// Number of decades towards rest.
    const DECADES: i32 = 6;
    const PER_DECADE: i32 = 16;
    let mut places: Vec<f64> =
        (1..=LINEAR).map(|k| amplitude * f64::from(k) / f64::from(LINEAR)).collect();
    places.extend(
        (1..=DECADES * PER_DECADE)
            .map(|k| amplitude * 10.0_f64.powf(-f64::from(k) / f64::from(PER_DECADE))),
    );
    // Both sides of a jump are sampled.
    let cuts = force.cuts(0.0, amplitude);
    places.extend(cuts.iter().flat_map(|cut| [cut * (1.0 - 1e-12), *cut, cut * (1.0 + 1e-12)]));
    places.retain(|place| *place > 0.0 && *place <= amplitude);
    places.sort_by(f64::total_cmp);
    places.dedup();
    let quotient = |x: f64| force.value(x) / x;
    let at_rest = Some(force.slope(0.0)).filter(|slope| slope.is_finite());
    let mut course = vec![(0.0, at_rest.unwrap_or_else(|| quotient(1e-9 * amplitude)))];
    course.extend(places.iter().map(|&place| (place, quotient(place))));
    // The quotient f/x is stationary where x f' = f.
    let rate = |x: f64| force.slope(x) - quotient(x);
    for pair in places.windows(2) {
        if rate(pair[0]) * rate(pair[1]) < 0.0
            && let Ok(place) = find_root(rate, pair[0], pair[1])
        {
            course.push((place, quotient(place)));
        }
    }
    course.sort_by(|one, other| one.0.total_cmp(&other.0));
    course.iter().all(|point| point.1.is_finite()).then_some(course)
}

/// The first place at which the values turn back by more than rounding.
fn first_extremum(course: &[(f64, f64)]) -> Option<f64> {
    let (mut highest, mut lowest) = (course[0], course[0]);
    let mut rising: Option<bool> = None;
    for &point in course {
        let visible = VISIBLE * highest.1.abs().max(lowest.1.abs());
        let (below, above) = (highest.1 - point.1 > visible, point.1 - lowest.1 > visible);
        match rising {
            None if above => rising = Some(true),
            None if below => rising = Some(false),
            Some(true) if below => return Some(highest.0),
            Some(false) if above => return Some(lowest.0),
            _ => {}
        }
        // The way back is measured from the last extreme.
        if point.1 >= highest.1 {
            highest = point;
        }
        if point.1 <= lowest.1 {
            lowest = point;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::{Options, solve};
    use crate::values::Values;
    use crate::verify::judge;

    /// Equation, values, whether the condition fails, words, and the two bounds stated.
    type Case =
        (&'static str, &'static [(&'static str, &'static str)], bool, &'static str, f64, f64);

    fn decided(equation: &str, at: &[(&str, &str)]) -> (Range, f64) {
        let oscillator = Oscillator::parse(equation).unwrap();
        let options = Options { method: Some(Method::MaxMin), ..Options::default() };
        let solution = solve(&oscillator, &options).unwrap();
        let mut values = Values::default();
        for (name, value) in at {
            values.insert((*name).into(), value.parse().unwrap()).unwrap();
        }
        let verification = judge(&oscillator, &solution, &values, 0.01).unwrap();
        let range = verification.ranges.into_iter().find(|range| range.text.starts_with("f(x)/x"));
        (range.expect(equation), verification.true_frequency.powi(2))
    }

    /// The two numbers at the end of a statement.
    fn pair(text: &str) -> (f64, f64) {
        let numbers = text.split([' ', ':', ',']);
        let numbers: Vec<f64> = numbers.filter_map(|word| word.parse().ok()).collect();
        (numbers[numbers.len() - 2], numbers[numbers.len() - 1])
    }

    #[test]
    fn the_condition_is_decided_and_the_true_frequency_lies_between() {
        let cases: [Case; 8] = [
            ("x'' + x + eps*x^3 = 0", &[("eps", "1.0"), ("A", "2.0")], false, "rises", 1.0, 5.0),
            ("x'' + k*x - x^3 = 0", &[("k", "4.0"), ("A", "-1.0")], false, "falls", 4.0, 3.0),
            // 1 - x^2 + b x^4 is least at x^2 = 1/(2 b).
            (
                "x'' + x - x^3 + b*x^5 = 0",
                &[("b", "0.5"), ("A", "0.9")],
                false,
                "falls",
                1.0,
                0.51805,
            ),
            (
                "x'' + x - x^3 + b*x^5 = 0",
                &[("b", "0.5"), ("A", "1.2")],
                true,
                "turns back at x = 1,",
                0.5,
                1.0,
            ),
            (
                "x'' + x - x^3 + b*x^5 = 0",
                &[("b", "0.5"), ("A", "2.0")],
                true,
                "turns back at x = 1,",
                0.5,
                5.0,
            ),
            (
                "x'' + 1e12*x - 1e24*x^3 + b*x^5 = 0",
                &[("b", "5e35"), ("A", "2e-6")],
                true,
                "x = 1e-6,",
                5e11,
                5e12,
            ),
            ("x'' + x + x*abs(x) = 0", &[("A", "1e9")], false, "rises", 1.0, 1e9),
            // 1 + b H(x - 1)/x steps up and comes down again.
            (
                "x'' + x + b*H(x - 1) - b*H(-x - 1) = 0",
                &[("b", "2.0"), ("A", "4.0")],
                true,
                "turns back at x = 1,",
                1.0,
                3.0,
            ),
        ];
        for (equation, at, outside, words, least, largest) in cases {
            let (range, squared) = decided(equation, at);
            assert_eq!(range.outside, outside, "{equation} at {at:?}: {}", range.text);
            assert!(range.text.contains(words), "{equation} at {at:?}: {}", range.text);
            let (one, other) = pair(&range.text);
            assert!(
                (one / least - 1.0).abs() < 1e-5 && (other / largest - 1.0).abs() < 1e-5,
                "{equation}: {}",
                range.text
            );
            let (low, high) = (one.min(other), one.max(other));
            assert!(low < squared && squared < high, "{equation}: {squared} of {}", range.text);
        }
        let (range, _) = decided("x'' + 3*x + b*sin(3*x) = 0", &[("b", "1.0"), ("A", "2.5")]);
        assert!(range.outside && range.text.contains("turns back at x = 1.4978"), "{}", range.text);
    }
}

//! The amplitude range of a formula: the first amplitude at which the error of its frequency
//! crosses the tolerance.
//!
//! The error is followed from rest outwards. Between two points its curvature is estimated from the
//! value in the middle: an interval that may contain a crossing is halved. Where the force, or the
//! formula, may vary on a short scale (corners, narrow bumps, poles) there are additional points,
//! and the amplitude asked for is always among them.

use std::collections::BTreeMap;

use super::backbone::TrueBackbone;
use super::formula::formula_frequency_along;
use crate::conservative::features::Features;
use crate::decimal::significant;
use crate::expr::Expr;
use crate::method::numbers::NumbersCache;
use crate::method::table::{MethodEntry, MotionEvaluation};
use crate::numeric::ode::root::{BisectionStop, bisect};
use crate::oscillator::Oscillator;
use crate::solution::{Method, Solution};
use crate::symbol::Symbol;

/// Sizes of the amplitude at which a law may vary on a short scale: the poles and narrow features
/// of its closed form.
pub(super) fn places_of_law(
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    to: f64,
) -> Vec<f64> {
    let symbol = solution.amplitude.symbol();
    let Some(form) = solution.law.closed_form() else {
        return vec![];
    };
    let mut law: Expr = form.value.clone();
    for definition in solution.definitions.iter().rev() {
        law = law.substitute(definition.symbol, &definition.meaning).unwrap_or(law);
    }
    let features = Features::new(&law, symbol, numbers);
    let mut cuts = features.cuts(0.0, to);
    // Points on both sides of a pole, close to it.
    let poles: Vec<f64> = features
        .between(0.0, to)
        .iter()
        .filter(|pole| pole.width == 0.0)
        .map(|pole| pole.place)
        .collect();
    cuts.extend(poles.iter().flat_map(|pole| [pole * (1.0 - 1e-6), pole * (1.0 + 1e-6)]));
    cuts.into_iter().map(|place| place * to.signum()).filter(|size| *size > 0.0).collect()
}

/// The amplitude range in which a formula is within the tolerance; amplitudes have their sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AmplitudeReach {
    /// All amplitudes of the search, up to this one.
    Everywhere(f64),
    /// Amplitudes up to this one.
    UpTo(f64),
    /// Between two amplitudes, for motions over several wells, which do not begin at rest, and for
    /// a law that is outside the tolerance near rest.
    Between {
        /// The lower end.
        from: f64,
        /// The upper end, or the end of the search.
        to: f64,
        /// Whether no crossing was found at the upper end.
        open: bool,
    },
    /// No amplitude.
    Nowhere,
}

impl AmplitudeReach {
    /// Whether an amplitude lies outside the range.
    pub fn leaves_out(self, amplitude: f64) -> bool {
        match self {
            Self::Between { from, to, open } => {
                amplitude.abs() < from.abs() || (!open && amplitude.abs() > to.abs())
            }
            Self::Everywhere(_) => false,
            Self::UpTo(end) => amplitude.abs() > end.abs(),
            Self::Nowhere => true,
        }
    }

    /// The end of the range; `None` if it has none.
    pub fn end(self) -> Option<f64> {
        match self {
            Self::UpTo(end) | Self::Between { to: end, open: false, .. } => Some(end),
            Self::Nowhere => Some(0.0),
            Self::Everywhere(_) | Self::Between { open: true, .. } => None,
        }
    }

    pub(super) fn in_words(self, tolerance: f64, amplitude: Symbol) -> String {
        let percent = significant(100.0 * tolerance, 3);
        match self {
            Self::Everywhere(searched) => format!(
                "within {percent} % at every amplitude looked at, up to {amplitude} = {}",
                significant(searched, 4)
            ),
            Self::UpTo(end) => {
                format!("within {percent} % up to {amplitude} = {}", significant(end, 4))
            }
            Self::Between { from, to, open } => {
                let [from, to] = [from, to].map(|end| significant(end, 4));
                match open {
                    true => {
                        format!(
                            "within {percent} % from {amplitude} = {from} on, looked at up to {amplitude} = {to}"
                        )
                    }
                    false => format!(
                        "within {percent} % from {amplitude} = {from} to {amplitude} = {to}"
                    ),
                }
            }
            Self::Nowhere => format!("within {percent} % at no amplitude"),
        }
    }
}

/// The range from rest in which the frequency stays within the tolerance; `None` if it cannot be
/// followed.
pub(super) fn amplitude_reach(
    oscillator: &Oscillator,
    solution: &Solution,
    truth: &TrueBackbone,
    tolerance: f64,
) -> Option<AmplitudeReach> {
    // There is no curve to follow if the amplitude changes, or is that of a limit cycle or a
    // response.
    let fixed =
        solution.limit_cycle.is_some() || solution.response.is_some() || solution.slow().is_some();
    if fixed {
        return None;
    }
    // Over the many hilltops of an oscillating force a balance has many solutions, and continuation
    // may find any of them.
    if MethodEntry::for_method(solution.method).motion == MotionEvaluation::Balance
        && truth.has_waves_of_hilltops()
    {
        return None;
    }
    let mut amplitudes = truth.amplitudes();
    let asked = truth.given_amplitude();
    let known = NumbersCache::default();
    let error = |size: f64| {
        let true_frequency = truth.frequency(size)?;
        let frequency =
            formula_frequency_along(oscillator, solution, &truth.numbers_at(size), &known);
        Some(frequency.map_or(f64::INFINITY, |frequency| frequency / true_frequency - 1.0))
    };
    if solution.method == Method::Exact {
        // The exact method agrees with the true motion wherever there is one.
        let good = error(asked.abs())?.abs() <= tolerance;
        let last = amplitudes.iter().rev().find(|&&size| truth.frequency(size).is_some());
        return last.filter(|_| good).map(|last| match truth.smallest_amplitude() {
            inner if inner > 0.0 => AmplitudeReach::Between {
                from: inner.copysign(asked),
                to: last.copysign(asked),
                open: true,
            },
            _ => AmplitudeReach::Everywhere(last.copysign(asked)),
        });
    }
    amplitudes.extend(places_of_law(
        solution,
        truth.numbers,
        asked.signum() * truth.search_limit(),
    ));
    amplitudes.retain(|size| *size <= truth.search_limit());
    amplitudes.sort_by(f64::total_cmp);
    if truth.smallest_amplitude() > 0.0 {
        amplitudes.retain(|size| *size > truth.smallest_amplitude());
        return about_the_amplitude(&error, &amplitudes, asked, tolerance);
    }
    let mut points = Vec::new();
    for &size in &amplitudes {
        match error(size) {
            Some(value) => points.push((size, value)),
            None => break,
        }
        if points.last().is_some_and(|point| point.1.abs() > tolerance) {
            break;
        }
    }
    let last = points.last()?.0;
    let follow = Follow { error: &error, tolerance, evaluations: std::cell::Cell::new(0) };
    let signed = |size: f64| size.copysign(asked);
    // Between rest and the smallest amplitude the law may vary on any scale.
    const SMALLEST: f64 = 1e-6;
    let first = points[0];
    let scales = std::iter::successors(Some(SMALLEST * first.0), |size| Some(2.0 * size));
    let smaller: Vec<(f64, f64)> = scales
        .take_while(|size| *size < first.0)
        .map_while(|size| Some((size, error(size)?)))
        // Very close to rest a formula may have no digits left.
        .skip_while(|point| point.1.is_infinite())
        .collect();
    match smaller.first() {
        Some(tiny) if tiny.1.abs() <= tolerance => {
            points.splice(0..0, smaller);
        }
        // A law outside the tolerance near rest may be within it farther out.
        _ if first.1.abs() > tolerance => {
            return about_the_amplitude(&error, &amplitudes, asked, tolerance);
        }
        _ => {}
    }
    for pair in points.windows(2) {
        if let Some(end) = follow.first_crossing(pair[0], pair[1]) {
            return Some(AmplitudeReach::UpTo(signed(end)));
        }
    }
    Some(AmplitudeReach::Everywhere(signed(last)))
}

/// The range about the amplitude asked for in which the frequency stays within the tolerance, or,
/// if it is not within it there, the outermost such range.
fn about_the_amplitude(
    error: &dyn Fn(f64) -> Option<f64>,
    amplitudes: &[f64],
    asked: f64,
    tolerance: f64,
) -> Option<AmplitudeReach> {
    // Close to the separatrix the true frequency may have no digits.
    let points: Vec<(f64, f64)> =
        amplitudes.iter().filter_map(|&size| Some((size, error(size)?))).collect();
    let good = |point: &(f64, f64)| point.1.abs() <= tolerance;
    let own = points.iter().position(|point| point.0 == asked.abs() && good(point));
    let Some(start) = own.or_else(|| points.iter().rposition(good)) else {
        return (!points.is_empty()).then_some(AmplitudeReach::Nowhere);
    };
    let follow = |pairs: Vec<[(f64, f64); 2]>| {
        let follow = Follow { error, tolerance, evaluations: std::cell::Cell::new(0) };
        pairs.into_iter().find_map(|[near, far]| match good(&far) {
            true => follow.first_crossing(near, far),
            false => Some(follow.crossing(near, far)),
        })
    };
    let outwards = follow(points[start..].windows(2).map(|pair| [pair[0], pair[1]]).collect());
    let inwards =
        follow(points[..=start].windows(2).rev().map(|pair| [pair[1], pair[0]]).collect());
    let last = points.last().map_or(asked, |point| point.0);
    let signed = |size: f64| size.copysign(asked);
    Some(AmplitudeReach::Between {
        from: signed(inwards.unwrap_or(points[0].0)),
        to: signed(outwards.unwrap_or(last)),
        open: outwards.is_none(),
    })
}

/// A search for the first crossing of a tolerance.
struct Follow<'a> {
    error: &'a dyn Fn(f64) -> Option<f64>,
    tolerance: f64,
    evaluations: std::cell::Cell<usize>,
}

impl Follow<'_> {
    /// The first crossing between two points, of which the first is good.
    fn first_crossing(&self, from: (f64, f64), to: (f64, f64)) -> Option<f64> {
        /// Largest number of bisections in total, and of one interval.
        const MOST: usize = 160;
        const DEEPEST: usize = 8;
        /// Ratio of the error to the tolerance beyond which one sample in the middle is not enough,
        /// because the error may bend either way.
        const CLOSE: f64 = 0.3;
        const LOOKS: usize = 3;
        let mut open = vec![(from, to, 0)];
        while let Some((low, high, depth)) = open.pop() {
            let middle = 0.5 * (low.0 + high.0);
            if depth >= DEEPEST || self.evaluations.get() >= MOST {
                if high.1.abs() > self.tolerance {
                    return Some(self.crossing(low, high));
                }
                continue;
            }
            let Some(value) = (self.error)(middle) else {
                // If nothing is known in between, the range ends with the last known amplitude.
                if high.1.abs() > self.tolerance {
                    return Some(low.0);
                }
                continue;
            };
            self.evaluations.set(self.evaluations.get() + 1);
            let middle = (middle, value);
            let straight = 0.5 * (low.1 + high.1);
            let bend = (value - straight).abs();
            let largest = low.1.abs().max(high.1.abs()).max(value.abs());
            if value.abs() <= self.tolerance
                && high.1.abs() <= self.tolerance
                && bend < 0.5 * (self.tolerance - largest)
                && (largest < CLOSE * self.tolerance || depth >= LOOKS)
            {
                continue;
            }
            if value.abs() > self.tolerance {
                // Everything beyond the middle is irrelevant once an error is found there.
                open.clear();
                if bend.is_finite() && bend < 0.1 * self.tolerance {
                    return Some(self.crossing(low, middle));
                }
            } else if high.1.abs() > self.tolerance
                && bend.is_finite()
                && bend < 0.1 * self.tolerance
            {
                return Some(self.crossing(middle, high));
            } else {
                open.push((middle, high, depth + 1));
            }
            open.push((low, middle, depth + 1));
        }
        None
    }

    /// The crossing between a good point and a bad one, by bisection.
    fn crossing(&self, good: (f64, f64), bad: (f64, f64)) -> f64 {
        let is_good =
            |size: f64| (self.error)(size).is_some_and(|error| error.abs() <= self.tolerance);
        let [last, _] = bisect(is_good, good.0, bad.0, BisectionStop::Halvings(14));
        last
    }
}

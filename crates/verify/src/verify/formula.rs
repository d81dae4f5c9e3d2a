//! The numbers of a formula: its frequency, its motion, and their loss of digits.

use std::collections::BTreeMap;

use super::validity;
use crate::decimal::significant;
use crate::exact::Doubles;
use crate::expr::Expr;
use crate::method::numbers::{
    NoNumbers, Numbers, NumbersCache, evaluate, frequency_squared_along, law_name,
};
use crate::oscillator::Oscillator;
use crate::series::FourierSeries;
use crate::solution::Solution;
use crate::symbol::Symbol;
use crate::symbol::letters::FREQUENCY;

/// omega by the formula: the root of omega^2; `None` if that is not positive.
pub(super) fn formula_frequency(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<f64> {
    formula_frequency_along(oscillator, solution, numbers, &NumbersCache::default())
}

/// Like [`formula_frequency`], for a sequence of amplitudes with all other values fixed.
pub(super) fn formula_frequency_along(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    known: &NumbersCache,
) -> Option<f64> {
    let squared = frequency_squared_along(oscillator, solution, numbers, known).ok()?;
    (squared > 0.0 && squared.is_finite()).then(|| squared.sqrt())
}

/// The numbers of a formula whose frequency is real, or the reason why there are none.
pub(super) fn numbers_or_reason(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> (Option<Numbers>, Option<NoNumbers>) {
    match evaluate(oscillator, solution, numbers) {
        Ok(found) if found.frequency_squared > 0.0 && found.frequency_squared.is_finite() => {
            (Some(found), None)
        }
        Ok(_) => (None, Some(NoNumbers::not_positive(solution))),
        Err(NoNumbers::NoValue | NoNumbers::Undefined { .. })
            if law_overflows(solution, numbers) =>
        {
            let law = law_name(solution);
            (None, Some(NoNumbers::LawBeyond { law }))
        }
        Err(reason) => (None, Some(reason)),
    }
}

/// Whether the law has no value because a part of it is larger than any number.
fn law_overflows(solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> bool {
    let law = match (solution.law.closed_form(), solution.law.frequency_squared()) {
        (Some(form), _) => form.value.clone(),
        (None, Some(squared)) => Expr::from(squared),
        (None, None) => return false,
    };
    law.overflow(numbers).is_some()
}

/// omega by its own series, if the formula has series of both omega and omega^2.
pub(super) fn series_of_omega(solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Option<f64> {
    solution.law.frequency_squared()?;
    let series = solution.law.frequency()?;
    solution.evaluate(series, &|symbol| numbers.get(&symbol).copied()).ok()
}

/// omega, the motion by the formula in theta, and the values that were chosen for it.
pub(super) fn formula_motion(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<(f64, FourierSeries<Doubles>)> {
    let found = evaluate(oscillator, solution, numbers).ok()?;
    Some((found.frequency_squared.sqrt(), found.motion?))
}

/// The loss of digits by cancellation, if the formula is evaluated far outside its range.
pub(super) fn cancellation(
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    found: Option<&Numbers>,
    max_deviation: Option<f64>,
) -> Vec<validity::Range> {
    /// Smaller relative errors are only reported to be smaller than this.
    const SHOWN: f64 = 1e-9;
    /// Half a unit in the third digit, to which deviations are printed.
    const OF_DEVIATION: f64 = 5e-4;
    let said = |what: &str, rounding: f64, of: &str| validity::Range {
        text: format!(
            "terms of high order cancel here: rounding moves {what} by {} of {of}",
            significant(rounding, 1)
        ),
        outside: false,
    };
    let law = found.map(|found| found.rounding).filter(|rounding| *rounding > SHOWN);
    let value_of = |symbol: Symbol| numbers.get(&symbol).copied();
    let motion = max_deviation.zip(solution.rounding_of_motion_at(&value_of));
    let motion =
        motion.filter(|(deviation, rounding)| *rounding > (OF_DEVIATION * deviation).max(SHOWN));
    let law = law.map(|rounding| said(&format!("{FREQUENCY}^2"), rounding, "itself"));
    let motion = motion.map(|(_, rounding)| said("the motion", rounding, "the amplitude"));
    law.into_iter().chain(motion).collect()
}

//! Constants of few digits near the best ones.
//!
//! In: a quotient of sums. Out: for each number of digits the constants with the smallest largest error.
//! One constant after the other is set to a short number near its best value, and those that are left
//! are found anew each time: a search in the lattice of short numbers, not rounding one by one. The
//! cost is that of some hundreds of fits.

use std::cmp::Ordering;

use num_traits::{One as _, Zero as _};

use super::formula::{length, text_of_number};
use super::minimax::{Fit, FitSteps, MOST_CONSTANTS, QuotientOfSums};
use crate::decimal::{self, ShortDecimal, neighbours, rounded_fraction};
use crate::exact::Rational;
use crate::exact::rational::{from_f64, ratio, to_f64};

/// The least and the greatest number of significant digits of the longest constants, which follows from the
/// error of the fit: digits far below that gain nothing.
const LEAST_DIGITS: usize = 4;
const MOST_DIGITS: usize = 12;

/// The number of choices that are followed for each number of digits.
const FOLLOWED: usize = 4;

/// Steps of a fit within the search.
const STEPS: FitSteps = FitSteps::all(12);

/// Constants that are short, in the order of the quotient of sums.
#[derive(Clone, Debug)]
pub(super) struct ShortConstants {
    pub(super) values: Vec<Rational>,
    /// A factor of the whole, where the first constant is one.
    pub(super) factor: Option<Rational>,
    pub(super) error: f64,
}

/// Some constants that are chosen, and the fit of the others.
struct Partial {
    chosen: Vec<Rational>,
    digits: usize,
    fit: Fit,
}

/// Short numbers about a value, each with its length, for a fit of this error.
pub(super) fn short_numbers(value: f64, error: f64) -> Vec<(Rational, usize)> {
    let digits = (-error.log10()).ceil() + 2.0;
    let most = (digits.clamp(LEAST_DIGITS as f64, MOST_DIGITS as f64)) as usize;
    if value == 0.0 || !value.is_finite() {
        return vec![];
    }
    let (size, is_negative) = (value.abs(), value < 0.0);
    let fractions = short_fractions(size);
    let decimals = (1..=most).map(|digits| neighbouring_decimals(size, digits));
    let decimals: Option<Vec<[(i64, i64); 2]>> = decimals.collect();
    let all = decimals.and_then(|decimals| {
        let all = decimals.into_iter().flatten().chain(fractions.iter().copied());
        let all = all.filter(|(above, _)| *above != 0);
        let with_length = |(above, below)| {
            let own = ratio_in_lowest_terms(above, below);
            Some((own, length_of_quotient(own)?))
        };
        all.map(with_length).collect::<Option<Vec<_>>>()
    });
    let Some(mut all) = all else { return numbers_of_any_size(value, most, &fractions) };
    all.sort_by(|((a, b), one), ((c, d), other)| {
        let product = |left: i64, right: i64| i128::from(left) * i128::from(right);
        let order = product(*a, *d).cmp(&product(*c, *b));
        let order = if is_negative { order.reverse() } else { order };
        order.then(one.cmp(other))
    });
    all.dedup();
    let sign = if is_negative { -1 } else { 1 };
    let number = |((above, below), length): ((i64, i64), usize)| {
        (Rational::new_raw((sign * above).into(), below.into()), length)
    };
    all.into_iter().map(number).collect()
}

/// The fractions of one digit over one or two, or of two over one, that are nearest to a positive number.
fn short_fractions(size: f64) -> Vec<(i64, i64)> {
    let mut fractions: Vec<(f64, i64, i64)> = (3..100)
        .filter_map(|below| {
            let above = (size * below as f64).round() as i64;
            (1..10).contains(&above).then(|| (above as f64 / below as f64, above, below))
        })
        .chain((1..10).filter_map(|below| {
            let above = (size * below as f64).round() as i64;
            (10..100).contains(&above).then(|| (above as f64 / below as f64, above, below))
        }))
        .collect();
    fractions.sort_by(|one, other| (one.0 - size).abs().total_cmp(&(other.0 - size).abs()));
    fractions.into_iter().take(4).map(|(_, above, below)| (above, below)).collect()
}

/// The decimals of so many digits next to a positive number, as [`neighbours`] finds them, as quotients; `None` for
/// numbers that are large or small, or of many digits.
fn neighbouring_decimals(size: f64, digits: usize) -> Option<[(i64, i64); 2]> {
    const SIZES: std::ops::Range<f64> = 1e-2..1e5;
    if !SIZES.contains(&size) || digits > MOST_DIGITS {
        return None;
    }
    // The number is a whole one over 2^places.
    let (mantissa, exponent, _) = num_traits::Float::integer_decode(size);
    let places = u32::from(exponent.unsigned_abs());
    let mut power = size.log10().floor() as i32 - digits as i32 + 1;
    loop {
        let ten = 10_u128.pow(power.unsigned_abs());
        let (above, below) = match power <= 0 {
            true => (u128::from(mantissa) * ten, 1 << places),
            false => (u128::from(mantissa), ten << places),
        };
        let (down, nearest) = (above / below, (2 * above + below) / (2 * below));
        match decimal::digits(u64::try_from(nearest).ok()?).cmp(&digits) {
            Ordering::Greater => power += 1,
            Ordering::Less => power -= 1,
            Ordering::Equal => {
                let ten = i64::try_from(ten).ok()?;
                let down = i64::try_from(down).ok()?;
                let up = down + i64::from(above % below != 0);
                let quotient = |count: i64| match power <= 0 {
                    true => Some((count, ten)),
                    false => Some((count.checked_mul(ten)?, 1)),
                };
                return Some([quotient(down)?, quotient(up)?]);
            }
        }
    }
}

/// A quotient of positive numbers in lowest terms.
fn ratio_in_lowest_terms(above: i64, below: i64) -> (i64, i64) {
    let shared = num_integer::Integer::gcd(&above, &below);
    (above / shared, below / shared)
}

/// The length of the text of a quotient of positive numbers in lowest terms; `None` if that has no short decimal
/// and may have a long one.
fn length_of_quotient((above, below): (i64, i64)) -> Option<usize> {
    let digits = |number: i64| decimal::digits(number.unsigned_abs());
    let fraction = if below == 1 { digits(above) } else { digits(above) + 1 + digits(below) };
    match ShortDecimal::of_quotient(above, below) {
        Some(own) => Some(own.digits().min(fraction)),
        None if below < 100 => Some(fraction),
        None => None,
    }
}

/// Short numbers about a value of any size, as those of [`short_numbers`].
fn numbers_of_any_size(
    value: f64,
    most: usize,
    fractions: &[(i64, i64)],
) -> Vec<(Rational, usize)> {
    let Some(exact) = from_f64(value) else { return vec![] };
    let decimals = (1..=most).flat_map(|digits| neighbours(&exact, digits));
    let sign = if value < 0.0 { -1 } else { 1 };
    let fractions = fractions.iter().map(|(above, below)| ratio(sign * above, *below));
    let mut all: Vec<(Rational, usize)> = decimals
        .chain(fractions)
        .filter(|number| !number.is_zero())
        .map(|number| {
            let digits = length(text_of_number(&number).trim_start_matches('-'));
            (number, digits)
        })
        .collect();
    all.sort();
    all.dedup();
    all
}

/// The best constants for each number of digits, from the fewest on, each with a smaller error than
/// those before. `is_scaled` gives the numerator the first constant one and the whole a factor.
pub(super) fn shortened(
    sums: &QuotientOfSums,
    best: &Fit,
    is_scaled: bool,
    most_digits: usize,
) -> Vec<(usize, ShortConstants)> {
    match is_scaled {
        false => plain(sums, best, most_digits),
        true => scaled(sums, best, most_digits),
    }
}

fn plain(sums: &QuotientOfSums, best: &Fit, most_digits: usize) -> Vec<(usize, ShortConstants)> {
    let count = sums.count();
    let mut partials = vec![Partial { chosen: vec![], digits: 0, fit: *best }];
    for next in 0..count {
        let mut grown: Vec<Partial> = vec![];
        for partial in &partials {
            for (number, digits) in short_numbers(partial.fit.constants[next], best.error) {
                let digits = partial.digits + digits;
                if digits + (count - next - 1) > most_digits {
                    continue;
                }
                let mut chosen = partial.chosen.clone();
                chosen.push(number);
                let mut fixed = [None; MOST_CONSTANTS];
                for (fixed, number) in fixed.iter_mut().zip(&chosen) {
                    *fixed = Some(to_f64(number));
                }
                if let Some(fit) = sums.minimax(&fixed[..count], STEPS) {
                    grown.push(Partial { chosen, digits, fit });
                }
            }
        }
        partials = followed(grown);
    }
    let whole = partials.into_iter().map(|partial| {
        let error = partial.fit.error;
        (partial.digits, ShortConstants { values: partial.chosen, factor: None, error })
    });
    improving(whole.collect())
}

/// The constants of `s (1 + sum t_i b_i)/(1 + ...)`: the ratios t are chosen one after the other while
/// the numerator has a free factor, and the factor at last.
fn scaled(sums: &QuotientOfSums, best: &Fit, most_digits: usize) -> Vec<(usize, ShortConstants)> {
    let count = sums.count();
    let numerators = sums.numerator.len();
    let mut partials = vec![Partial { chosen: vec![], digits: 0, fit: *best }];
    for next in 1..count {
        let mut grown: Vec<Partial> = vec![];
        for partial in &partials {
            let value = match next < numerators {
                true => partial.fit.constants[next] / partial.fit.constants[0],
                false => partial.fit.constants[next],
            };
            for (number, digits) in short_numbers(value, best.error) {
                let digits = partial.digits + digits;
                if digits + (count - next - 1) + 1 > most_digits {
                    continue;
                }
                let mut chosen = partial.chosen.clone();
                chosen.push(number);
                if let Some(fit) = fit_with_ratios(sums, &chosen) {
                    grown.push(Partial { chosen, digits, fit });
                }
            }
        }
        partials = followed(grown);
    }
    let mut whole = vec![];
    for partial in partials {
        let factor = partial.fit.constants[0].powf(sums.power.exponent());
        for (factor, digits) in short_numbers(factor, best.error) {
            // A factor of one is not written.
            let digits = partial.digits + if factor.is_one() { 0 } else { digits };
            if digits > most_digits {
                continue;
            }
            let mut constants = partial.fit.constants;
            let scale = to_f64(&factor).powf(1.0 / sums.power.exponent()) / constants[0];
            constants[..numerators].iter_mut().for_each(|constant| *constant *= scale);
            let error = sums.largest_error(&constants[..count]);
            let mut values = vec![Rational::one()];
            values.extend(partial.chosen.iter().cloned());
            whole.push((digits, ShortConstants { values, factor: Some(factor), error }));
        }
    }
    improving(whole)
}

/// The fit of the factor of the numerator, and of the constants that are not chosen yet.
fn fit_with_ratios(sums: &QuotientOfSums, chosen: &[Rational]) -> Option<Fit> {
    let numerators = sums.numerator.len();
    let ratios: Vec<f64> = chosen.iter().map(to_f64).collect();
    let own = ratios.len().min(numerators - 1);
    let places = sums.places();
    let head: Vec<f64> = (0..places)
        .map(|place| {
            let rest = (0..own).map(|i| ratios[i] * sums.numerator[i + 1][place]);
            sums.numerator[0][place] + rest.sum::<f64>()
        })
        .collect();
    let mut numerator: Vec<&[f64]> = vec![&head];
    numerator.extend(&sums.numerator[own + 1..]);
    let left = numerator.len();
    let reduced = QuotientOfSums {
        numerator,
        denominator: sums.denominator.clone(),
        power: sums.power,
        tie: None,
    };
    let mut fixed = [None; MOST_CONSTANTS];
    for (j, ratio) in ratios[own..].iter().enumerate() {
        fixed[left + j] = Some(*ratio);
    }
    let fit = reduced.minimax(&fixed[..reduced.count()], STEPS)?;
    let mut constants = [0.0; MOST_CONSTANTS];
    constants[0] = fit.constants[0];
    for i in 0..own {
        constants[i + 1] = ratios[i] * fit.constants[0];
    }
    let rest = sums.count() - own - 1;
    constants[own + 1..=own + rest].copy_from_slice(&fit.constants[1..=rest]);
    Some(Fit { constants, error: fit.error })
}

/// The best choices for each number of digits.
fn followed(mut grown: Vec<Partial>) -> Vec<Partial> {
    grown.sort_by(|one, other| {
        one.digits.cmp(&other.digits).then(one.fit.error.total_cmp(&other.fit.error))
    });
    let mut kept: Vec<Partial> = vec![];
    let (mut digits, mut number) = (0, 0);
    for partial in grown {
        (digits, number) = match partial.digits == digits {
            true => (digits, number + 1),
            false => (partial.digits, 0),
        };
        if number < FOLLOWED && partial.fit.error.is_finite() {
            kept.push(partial);
        }
    }
    kept
}

/// Constants with a smaller error than all of fewer digits.
fn improving(mut whole: Vec<(usize, ShortConstants)>) -> Vec<(usize, ShortConstants)> {
    whole.sort_by(|one, other| one.0.cmp(&other.0).then(one.1.error.total_cmp(&other.1.error)));
    let mut least = f64::INFINITY;
    whole.retain(|(_, constants)| {
        let is_better = constants.error < least;
        least = least.min(constants.error);
        is_better
    });
    whole
}

/// The number of few digits nearest to a value that is rounded up.
pub(super) fn rounded_error(error: f64) -> Rational {
    /// Digits of a bound, and the part of itself by which it is at least above what was measured.
    const DIGITS: usize = 3;
    const ABOVE: f64 = 1.0005;
    let bound = from_f64(error * ABOVE).unwrap_or_else(Rational::one);
    let [_, above] = neighbours(&bound, DIGITS);
    rounded_fraction(&above, DIGITS)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against fractions of any size, about numbers with few digits and many.
    #[test]
    fn short_numbers_are_those_of_any_size() {
        let values =
            [0.5, 0.02, 0.0999, 0.96, 9.96, 1.0, 12.5, 0.125, 1.0 / 3.0, 2.0 / 7.0, 99_999.5];
        let others =
            [std::f64::consts::PI, std::f64::consts::FRAC_1_SQRT_2, 1_234.567_89, 0.099_96];
        for value in values.into_iter().chain(others).flat_map(|value| [value, -value]) {
            for (error, most) in [(1e-2, 4), (3e-5, 7), (1e-11, 12)] {
                let expected = numbers_of_any_size(value, most, &short_fractions(value.abs()));
                assert_eq!(short_numbers(value, error), expected, "{value}");
                assert!(neighbouring_decimals(value.abs(), most).is_some());
            }
        }
    }
}

//! Decimal text of numbers, and the fractions that decimals stand for.
//!
//! In: a double or a fraction, and a number of digits. Out: decimal text, or the fraction that
//! these digits stand for.

use num_traits::{Pow, Signed, ToPrimitive as _, Zero};

use crate::exact::rational::{from_f64, to_f64};
use crate::exact::scaled::Scaled;
use crate::exact::{Integer, Rational};

/// Returns a number with six significant digits, in the usual form: `0.860608`, `3.0407e7`,
/// `-1.49`.
///
/// ```
/// use lindstedt_expr::decimal::decimal;
///
/// assert_eq!([decimal(0.8606080), decimal(3.0407e7)], ["0.860608", "3.0407e7"]);
/// ```
pub fn decimal(value: f64) -> String {
    significant(value, 6)
}

/// Returns `value` with this many significant digits, without trailing zeros.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    if (-4..digits as i32).contains(&exponent) {
        let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
        return trimmed(&format!("{value:.decimals$}"));
    }
    format!("{}e{exponent}", trimmed(mantissa))
}

/// Returns a number rounded to fifteen significant digits, as a fraction.
pub fn rounded(value: f64) -> Rational {
    rounded_to(value, 15)
}

/// Returns a number rounded to this many significant digits, as a fraction; seventeen digits tell
/// any two doubles apart.
pub fn rounded_to(value: f64, digits: usize) -> Rational {
    let decimals = digits.saturating_sub(1);
    parsed(&format!("{value:.decimals$e}"))
}

/// The fraction of a decimal in the notation of `{:e}`.
fn parsed(text: &str) -> Rational {
    let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let digits: Integer = mantissa.replace('.', "").parse().unwrap_or_default();
    let power = exponent.parse::<i32>().unwrap_or(0) - decimals as i32;
    let ten = Rational::from_integer(10.into());
    let scale = num_traits::pow(ten, power.unsigned_abs() as usize);
    let digits = Rational::from_integer(digits);
    if power < 0 { digits / scale } else { digits * scale }
}

/// A fraction rounded to this many significant digits, as a fraction, however large or small it is.
pub fn rounded_fraction(value: &Rational, digits: usize) -> Rational {
    let (mantissa, power) = scientific(value, digits);
    Rational::from_integer(mantissa) * Pow::pow(Rational::from_integer(10.into()), power)
}

/// Returns the two decimals of this many significant digits next to a fraction, the first not above
/// it and the second not below; both are the fraction itself if it is such a decimal.
pub fn neighbours(value: &Rational, digits: usize) -> [Rational; 2] {
    let (count, power) = in_units(value, digits);
    let unit: Rational = Pow::pow(Rational::from_integer(10.into()), power);
    [count.floor() * &unit, count.ceil() * unit]
}

/// Returns a fraction with this many significant digits, as [`significant`] writes a double; the
/// fraction may lie beyond the range of doubles.
pub fn significant_fraction(value: &Rational, digits: usize) -> String {
    let double = to_f64(value);
    if value.is_zero() || double.is_normal() {
        return significant(double, digits);
    }
    let (mantissa, power) = scientific(value, digits);
    in_powers(value, &mantissa, power)
}

/// Writes `mantissa * 10^power` in the form `1.5e300`, with the sign of `value`.
fn in_powers(value: &Rational, mantissa: &Integer, power: i32) -> String {
    let sign = if value.is_negative() { "-" } else { "" };
    let text = mantissa.abs().to_string();
    let (first, rest) = text.split_at(1);
    let rest = rest.trim_end_matches('0');
    let point = if rest.is_empty() { "" } else { "." };
    let exponent = power + text.len() as i32 - 1;
    format!("{sign}{first}{point}{rest}e{exponent}")
}

/// Returns a number, not negative, rounded down to this many significant digits, as [`significant`]
/// writes it.
pub fn rounded_down(value: f64, digits: usize) -> String {
    rounded_to_side(value, digits, 0)
}

/// Returns a number, not negative, rounded up to this many significant digits, as [`significant`]
/// writes it.
pub fn rounded_up(value: f64, digits: usize) -> String {
    rounded_to_side(value, digits, 1)
}

fn rounded_to_side(value: f64, digits: usize, side: usize) -> String {
    match from_f64(value) {
        Some(exact) => significant_fraction(&neighbours(&exact, digits)[side], digits),
        None => value.to_string(),
    }
}

/// Returns the fraction that the shortest decimal of a finite double stands for, 1/100 for `0.01`:
/// the number that was typed, if it had at most fifteen digits.
pub fn as_typed(value: f64) -> Rational {
    parsed(&format!("{value:e}"))
}

/// Returns the largest double that is not above the decimal that a double was [typed as](as_typed).
pub fn not_above_typed(value: f64) -> f64 {
    match from_f64(value) {
        Some(exact) if exact > as_typed(value) => value.next_down(),
        _ => value,
    }
}

/// Returns a fraction as a decimal in full, as [`significant`] writes it; `None` if it would need
/// more than forty significant digits.
pub fn exact_decimal(value: &Rational) -> Option<String> {
    match ShortDecimal::of_fraction(value) {
        Some(short) => Some(short.to_string()),
        None => long_decimal(value),
    }
}

/// Returns a fraction of any number of digits as a decimal in full, as [`exact_decimal`] does.
fn long_decimal(value: &Rational) -> Option<String> {
    const MOST: usize = 40;
    let ten = Integer::from(10);
    let mut rest = value.denom().clone();
    let decimals = without_factors(&mut rest, 5).max(without_factors(&mut rest, 2));
    if rest != Integer::from(1) {
        return None;
    }
    let mut mantissa =
        (value * Pow::pow(Rational::from_integer(ten.clone()), decimals)).to_integer();
    let mut power = -decimals;
    // A zero at the end of the digits needs a whole number.
    while power >= 0 && !mantissa.is_zero() && (&mantissa % &ten).is_zero() {
        mantissa /= &ten;
        power += 1;
    }
    let digits = mantissa.abs().to_string().len();
    let exponent = power + digits as i32 - 1;
    (digits <= MOST).then(|| match (-4..15).contains(&exponent) {
        true => fixed(value, usize::try_from(-power).unwrap_or(0)),
        false => in_powers(value, &mantissa, power),
    })
}

/// A decimal `mantissa * 10^-decimals` of few digits, written without a power of ten. No digit behind the point is a
/// trailing zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShortDecimal {
    /// The digits.
    mantissa: i64,
    /// Number of digits behind the point.
    decimals: u32,
}

impl ShortDecimal {
    /// The decimal that a fraction is; `None` if it is none, or has more than fourteen digits, or is smaller than
    /// a thousandth.
    pub fn of_fraction(value: &Rational) -> Option<Self> {
        Self::of_quotient(value.numer().to_i64()?, value.denom().to_i64()?)
    }

    /// The decimal that a quotient in lowest terms is; `None` as for [`of_fraction`](Self::of_fraction).
    pub fn of_quotient(numerator: i64, denominator: i64) -> Option<Self> {
        /// No longer number is short, and so no power of two or five that divides a power of ten.
        const MOST: i64 = 100_000_000_000_000;
        const LEAST: i64 = 1_000;
        let (mut rest, mut twos, mut fives) = (denominator, 0, 0);
        if rest <= 0 || rest > MOST || numerator.unsigned_abs() >= MOST.unsigned_abs() {
            return None;
        }
        while rest % 2 == 0 {
            (rest, twos) = (rest / 2, twos + 1);
        }
        while rest % 5 == 0 {
            (rest, fives) = (rest / 5, fives + 1);
        }
        let decimals = u32::max(twos, fives);
        let factor = 2_i64
            .checked_pow(decimals - twos)?
            .checked_mul(5_i64.checked_pow(decimals - fives)?)?;
        let mantissa = numerator.checked_mul(factor)?;
        let is_small = numerator != 0
            && numerator.unsigned_abs() < denominator.unsigned_abs().div_ceil(LEAST.unsigned_abs());
        (rest == 1 && !is_small && mantissa.unsigned_abs() < MOST.unsigned_abs())
            .then_some(Self { mantissa, decimals })
    }

    /// The number of its digits, zeros in front left out.
    pub const fn digits(self) -> usize {
        digits(self.mantissa.unsigned_abs())
    }
}

/// The number of digits of a whole number.
pub const fn digits(number: u64) -> usize {
    match number.checked_ilog10() {
        Some(tens) => tens as usize + 1,
        None => 1,
    }
}

impl std::fmt::Display for ShortDecimal {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let sign = if self.mantissa < 0 { "-" } else { "" };
        let unit = 10_u64.pow(self.decimals);
        let size = self.mantissa.unsigned_abs();
        match self.decimals {
            0 => write!(formatter, "{sign}{size}"),
            decimals => {
                write!(
                    formatter,
                    "{sign}{}.{:0width$}",
                    size / unit,
                    size % unit,
                    width = decimals as usize
                )
            }
        }
    }
}

/// Divides a number by a factor as often as it goes, and counts how often that is.
fn without_factors(number: &mut Integer, factor: u32) -> i32 {
    let factor = Integer::from(factor);
    let mut count = 0;
    while (&*number % &factor).is_zero() {
        *number /= &factor;
        count += 1;
    }
    count
}

/// Returns a fraction with at most this many decimals, without trailing zeros; with fifteen
/// significant digits if it is very large or small.
pub fn plain_decimal(value: &Rational, decimals: usize) -> String {
    match has_plain_decimals(value) {
        true => fixed(value, decimals),
        false => significant_fraction(&rounded_fraction(value, 15), 15),
    }
}

/// The fraction that [`plain_decimal`] prints.
pub fn plain_fraction(value: &Rational, decimals: usize) -> Rational {
    match has_plain_decimals(value) {
        true => {
            let unit = Rational::from_integer(Integer::from(10).pow(decimals as u32));
            (value * &unit).round() / unit
        }
        false => rounded_fraction(value, 15),
    }
}

fn has_plain_decimals(value: &Rational) -> bool {
    value.is_zero() || (1e-5..1e15).contains(&to_f64(value).abs())
}

fn fixed(value: &Rational, decimals: usize) -> String {
    let unit = Integer::from(10).pow(decimals as u32);
    let digits = (value.abs() * Rational::from_integer(unit)).round().to_integer().to_string();
    let digits = format!("{digits:0>width$}", width = decimals + 1);
    let (whole, fraction) = digits.split_at(digits.len() - decimals);
    let fraction = fraction.trim_end_matches('0');
    let sign = if value.is_negative() { "-" } else { "" };
    let point = if fraction.is_empty() { "" } else { "." };
    format!("{sign}{whole}{point}{fraction}")
}

/// Whether a fraction is a terminating decimal.
pub fn ends(value: &Rational) -> bool {
    let mut rest = value.denom().clone();
    for factor in [5, 2] {
        without_factors(&mut rest, factor);
    }
    rest == Integer::from(1)
}

/// Returns the decimal of a long fraction, if it terminates and is shorter than the fraction:
/// `1e-300`, `3.00853856091339`. Returns `None` for short fractions and all others.
pub fn decimal_of_long_fraction(value: &Rational) -> Option<String> {
    /// The longest text that is kept as a fraction, in characters.
    const SHORT: usize = 12;
    /// The longest whole number that is written out, in digits.
    const WRITTEN_OUT: usize = 21;
    /// The longest numerator or denominator, in bits; nobody types a longer one into an equation.
    const LONGEST_BITS: u64 = 4_000;
    /// Digits that tell any two doubles apart: a number with more was neither rounded nor typed.
    const DIGITS: usize = 17;
    let bits = [value.numer(), value.denom()].map(Integer::bits);
    if bits.iter().sum::<u64>() < 30 || bits.iter().any(|bits| *bits > LONGEST_BITS) {
        return None;
    }
    let ten = Integer::from(10);
    // The fraction is m/10^k if its denominator is 2^a 5^b, with k the larger of a and b.
    let mut rest = value.denom().clone();
    let mut decimals: i32 = 0;
    for factor in [5, 2] {
        // More than 25 twos beyond the fives are too many: m has a factor 5 for each of them.
        if rest.bits() > decimals.unsigned_abs() as u64 + 26 && factor == 2 {
            return None;
        }
        decimals = decimals.max(without_factors(&mut rest, factor));
    }
    if rest != Integer::from(1) {
        return None;
    }
    let mut mantissa =
        (value.abs() * Pow::pow(Rational::from_integer(ten.clone()), decimals)).to_integer();
    // Each zero at the end needs a factor 2. If too many digits are left even without as many zeros,
    // they need not be counted. A binary digit is more than 0.301 decimal ones.
    let halvings = mantissa.halvings().unwrap_or(0) as u64;
    if 301 * mantissa.bits().saturating_sub(1) / 1000 >= DIGITS as u64 + halvings {
        return None;
    }
    while decimals <= 0 && (&mantissa % &ten).is_zero() && !mantissa.is_zero() {
        mantissa /= &ten;
        decimals -= 1;
    }
    let digits = mantissa.to_string();
    if digits.len() > DIGITS {
        return None;
    }
    let exponent = digits.len() as i32 - 1 - decimals;
    let with_point = |digits: &str, whole: usize| match digits.split_at(whole) {
        (whole, "") => whole.to_owned(),
        (whole, fraction) => format!("{whole}.{fraction}"),
    };
    let text = match exponent {
        -4..0 => format!("0.{}{digits}", "0".repeat(exponent.unsigned_abs() as usize - 1)),
        0.. if decimals >= 0 && (exponent as usize) < WRITTEN_OUT => {
            with_point(&digits, exponent as usize + 1)
        }
        _ => format!("{}e{exponent}", with_point(&digits, 1)),
    };
    let fraction = value.abs().to_string().len();
    let longest = if value.is_integer() { WRITTEN_OUT } else { SHORT };
    let sign = if value.is_negative() { "-" } else { "" };
    (fraction > longest && text.len() < fraction).then(|| format!("{sign}{text}"))
}

/// Returns a whole number of this many digits and a power of ten, whose product is the rounded
/// fraction.
fn scientific(value: &Rational, digits: usize) -> (Integer, i32) {
    let (count, power) = in_units(value, digits);
    (count.round().to_integer(), power)
}

/// Returns a fraction in units of a power of ten, and that power: rounded, it has this many digits.
fn in_units(value: &Rational, digits: usize) -> (Rational, i32) {
    if value.is_zero() {
        return (Rational::zero(), 0);
    }
    // The logarithm may be off by one: a digit too many or too few is corrected.
    let logarithm = Scaled::of_fraction(value).logarithm() / std::f64::consts::LN_10;
    let mut power = logarithm.floor() as i32 - digits as i32 + 1;
    loop {
        let count = value / Pow::pow(Rational::from_integer(10.into()), power);
        match count.round().to_integer().abs().to_string().len() {
            found if found > digits => power += 1,
            found if found < digits => power -= 1,
            _ => return (count, power),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the decimals of any number of digits.
    #[test]
    fn short_decimals_are_written_as_all_others() {
        for denominator in
            [1, 2, 5, 8, 10, 40, 125, 128, 3, 1_000, 15_625, 1_048_576, 1_000_000_000]
        {
            for numerator in
                [0, 1, -1, 7, 99, 100, -1_200, 4_095, 123_457, 10_000_000, 99_999_999_999_999]
            {
                let value = crate::exact::rational::ratio(numerator, denominator);
                let (expected, own) = (long_decimal(&value), ShortDecimal::of_fraction(&value));
                if let Some(own) = own {
                    let text = own.to_string();
                    let digits = text.replace(['-', '.'], "");
                    assert_eq!(own.digits(), digits.trim_start_matches('0').len().max(1), "{text}");
                    assert_eq!(Some(text), expected);
                }
                let is_short =
                    numerator.abs() < 200_000 && denominator.abs() < 2_000 && denominator != 3;
                assert!(own.is_some() || !is_short || numerator.abs() < denominator, "{value}");
            }
        }
    }

    #[test]
    fn as_people_write_them() {
        for (value, expected) in [
            (0.860_608_346_68, "0.860608"),
            (-1.5, "-1.5"),
            (3.040_7e7, "3.0407e7"),
            (9.258e-8, "9.258e-8"),
            (0.000_123_456_78, "0.000123457"),
            (1_066.23, "1066.23"),
            (999_999.96, "1e6"),
            (0.0, "0"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(decimal(value), expected);
        }
    }

    #[test]
    fn rounding_keeps_fifteen_digits() {
        assert_eq!(rounded(0.1), Rational::new(1.into(), 10.into()));
        assert_eq!(
            rounded(-2.5e20),
            Rational::from_integer((-250_000_000_000_000_000_000_i128).into())
        );
        assert_eq!(rounded(0.0), Rational::from_integer(0.into()));
    }

    #[test]
    fn long_fractions_of_few_digits() {
        let ten = Rational::from_integer(10.into());
        let text = |number: i64, power: i32| {
            let value = Rational::from_integer(number.into()) * Pow::pow(ten.clone(), power);
            decimal_of_long_fraction(&value)
        };
        assert_eq!(text(1, 30).as_deref(), Some("1e30"));
        assert_eq!(text(-7, -300).as_deref(), Some("-7e-300"));
        // All digits that are kept, with as many factors 2 as there are zeros, and with more.
        for number in [12_345_678_901_234_567_i64, 9_007_199_254_740_992] {
            let digits = number.to_string();
            let expected = format!("{}.{}e", &digits[..1], &digits[1..]);
            for power in [40, 500] {
                let found = text(number, power).unwrap_or_default();
                assert_eq!(found, format!("{expected}{}", power as usize + digits.len() - 1));
            }
        }
        assert_eq!(text(123_456_789_012_345_678, 500), None);
        let two = Rational::from_integer(2.into());
        assert_eq!(decimal_of_long_fraction(&Pow::pow(two, 3000)), None);
    }

    #[test]
    fn fractions_of_any_size() {
        let ten = |power: i32| Pow::pow(Rational::from_integer(10.into()), power);
        let third = Rational::new(1.into(), 3.into());
        for power in [-2000, -400, -308, 0, 308, 400, 2000] {
            let value = -&third * ten(power);
            let expected = Rational::from_integer((-333_333).into()) * ten(power - 6);
            assert_eq!(rounded_fraction(&value, 6), expected);
            // Rounding up to one digit more.
            let nines = ten(power) - ten(power - 20);
            assert_eq!(rounded_fraction(&nines, 15), ten(power));
        }
        assert_eq!(rounded_fraction(&Rational::zero(), 15), Rational::zero());
        assert_eq!(significant_fraction(&third, 6), "0.333333");
        assert_eq!(significant_fraction(&(-&third * ten(500)), 6), "-3.33333e499");
        assert_eq!(significant_fraction(&ten(-400), 6), "1e-400");
        let long = Rational::new(10_i64.pow(17).into(), (3 * 10_i64.pow(16)).into());
        assert_eq!(plain_decimal(&-long, 20), "-3.33333333333333333333");
        let texts = [ten(0), ten(-3) * &third, ten(30), Rational::zero()]
            .map(|value| plain_decimal(&value, 6));
        assert_eq!(texts, ["1", "0.000333", "1e30", "0"]);
    }
}

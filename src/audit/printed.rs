//! A number as it is printed: its digits tell its accuracy.
//!
//! In: text such as `0.8478`, `+0.99413`, `9.258e-8`, `7/1536`, `0.586 %` or `< 2 %`. Out: whether
//! a computed number has these digits, rounded or cut off, lies within a tolerance, or on the right
//! side of a bound.

use crate::decimal::significant;
use crate::exact::Rational;
use crate::exact::rational::to_f64;
use crate::expr::parse_expression;

/// The rule by which digits are cut or rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Rounding {
    /// Rounding to nearest: `rounded`.
    #[default]
    Rounded,
    /// Cut off behind the last one: `cut`.
    Cut,
    /// Either way, independently for each number: `either`.
    Either,
}

impl Rounding {
    /// Every way.
    pub const ALL: [Self; 3] = [Self::Rounded, Self::Cut, Self::Either];

    /// The name in a file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rounded => "rounded",
            Self::Cut => "cut",
            Self::Either => "either",
        }
    }

    /// The way of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|way| way.name() == name)
    }
}

/// The relation of a printed number to the true one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// The true number is this one.
    Equal,
    /// The true number is below, `<` or `<=`.
    Below,
    /// The true number is above, `>` or `>=`.
    Above,
}

/// A number as it is printed.
#[derive(Clone, Debug, PartialEq)]
pub struct Printed {
    /// The relation to the true number.
    pub relation: Relation,
    /// Whether the bound itself is allowed.
    with_bound: bool,
    /// The number.
    pub value: f64,
    /// Its exact value, if it is written as a fraction or without a decimal point.
    exact: Option<Rational>,
    /// The digits before the exponent, as printed, without the sign.
    digits: String,
    /// The factor of those digits: 0.01 for per cent, 1e-8 for `e-8`.
    scale: f64,
    /// Whether it is printed in per cent.
    percent: bool,
}

impl Printed {
    /// Reads a number; `None` if the text is not a number.
    ///
    /// ```
    /// use lindstedt::audit::{Printed, Rounding};
    ///
    /// let printed = Printed::read("1.3537").ok_or("no number")?;
    /// assert!(!printed.is_reproduced_by(1.353763, Rounding::Rounded, None));
    /// assert!(printed.is_reproduced_by(1.353763, Rounding::Cut, None));
    /// # Ok::<(), &str>(())
    /// ```
    pub fn read(text: &str) -> Option<Self> {
        let text = text.trim();
        let signs = [
            ("<=", Relation::Below, true),
            (">=", Relation::Above, true),
            ("<", Relation::Below, false),
            (">", Relation::Above, false),
        ];
        let found = signs.into_iter().find_map(|(sign, relation, bound)| {
            Some((text.strip_prefix(sign)?.trim(), relation, bound))
        });
        let (text, relation, with_bound) = found.unwrap_or((text, Relation::Equal, false));
        let (number, percent) = match text.strip_suffix('%') {
            Some(number) => (number.trim_end(), 0.01),
            None => (text, 1.0),
        };
        let unsigned = number.trim_start_matches(['+', '-']);
        if number.len() > unsigned.len() + 1 {
            return None;
        }
        let all_digits =
            |text: &str| !text.is_empty() && text.bytes().all(|letter| letter.is_ascii_digit());
        if let Some((above, below)) = unsigned.split_once('/') {
            if !(all_digits(above) && all_digits(below)) || percent != 1.0 {
                return None;
            }
            let fraction = parse_expression(number.trim_start_matches('+')).ok()?;
            let fraction = fraction.as_number()?.clone();
            return Some(Self {
                relation,
                with_bound,
                value: to_f64(&fraction),
                exact: Some(fraction),
                digits: String::new(),
                scale: 1.0,
                percent: false,
            });
        }
        let (digits, exponent) = unsigned.split_once(['e', 'E']).unwrap_or((unsigned, "0"));
        let (whole, part) = digits.split_once('.').unwrap_or((digits, "0"));
        let exponent: i32 = exponent.parse().ok().filter(|size: &i32| size.abs() <= 300)?;
        // A leading zero may be left out.
        let is_whole_number = all_digits(whole) || whole.is_empty() && digits.contains('.');
        if !(is_whole_number && all_digits(part)) {
            return None;
        }
        let value = number.parse::<f64>().ok()? * percent;
        let is_whole = percent == 1.0 && exponent == 0 && !digits.contains('.');
        let whole_number = || parse_expression(unsigned).ok()?.as_number().cloned();
        let exact = if is_whole { whole_number() } else { None };
        Some(Self {
            relation,
            with_bound,
            value,
            exact: exact.map(|size| if value < 0.0 { -size } else { size }),
            digits: digits.to_owned(),
            scale: percent * 10_f64.powi(exponent),
            percent: percent != 1.0,
        })
    }

    /// Digits behind the decimal point.
    fn decimals(&self) -> usize {
        self.digits.split_once('.').map_or(0, |(_, part)| part.len())
    }

    /// Number of significant digits.
    pub fn significant_digits(&self) -> usize {
        let digits = self.digits.bytes().filter(u8::is_ascii_digit);
        digits.skip_while(|digit| *digit == b'0').count()
    }

    /// Whether a number agrees with the printed one: by its digits, within a relative tolerance, or
    /// on the right side of a bound. NaN never agrees.
    pub fn is_reproduced_by(
        &self,
        number: f64,
        rounding: Rounding,
        tolerance: Option<f64>,
    ) -> bool {
        let is_bound = self.with_bound && number == self.value;
        match (self.relation, tolerance) {
            (Relation::Below, _) => number < self.value || is_bound,
            (Relation::Above, _) => number > self.value || is_bound,
            (Relation::Equal, Some(tolerance)) => {
                (number - self.value).abs() <= tolerance * self.value.abs()
            }
            // A fraction has no last digit.
            (Relation::Equal, None) if self.digits.is_empty() => {
                (number - self.value).abs() <= 1e-12 * self.value.abs()
            }
            (Relation::Equal, None) => match rounding {
                Rounding::Rounded => self.has_digits_of(number),
                Rounding::Cut => self.has_digits_of(self.cut(number)),
                Rounding::Either => {
                    self.has_digits_of(number) || self.has_digits_of(self.cut(number))
                }
            },
        }
    }

    /// Whether a fraction reproduces the printed number: one that is printed as a fraction must be
    /// equal to it.
    pub fn is_reproduced_exactly_by(
        &self,
        number: &Rational,
        rounding: Rounding,
        tolerance: Option<f64>,
    ) -> bool {
        match (&self.exact, self.relation, tolerance) {
            (Some(exact), Relation::Equal, None) => exact == number,
            _ => self.is_reproduced_by(to_f64(number), rounding, tolerance),
        }
    }

    /// The number cut off after the last printed digit.
    fn cut(&self, number: f64) -> f64 {
        let unit = self.scale * 10_f64.powi(-(self.decimals() as i32));
        // The factor keeps a last digit that rounding of doubles would lose.
        let units = (number.abs() / unit * (1.0 + 1e-13)).trunc();
        (units * unit).copysign(number)
    }

    fn has_digits_of(&self, number: f64) -> bool {
        let written = format!("{:.*}", self.decimals(), number.abs() / self.scale);
        let zeros = written.bytes().all(|letter| !letter.is_ascii_digit() || letter == b'0');
        let written = written.trim_start_matches('0');
        // A zero is printed without a sign; a leading zero may be left out.
        written == self.digits.trim_start_matches('0')
            && (zeros || (number < 0.0) == (self.value < 0.0))
    }

    /// The middle of the interval of numbers with this printed form.
    pub(super) fn middle(&self, rounding: Rounding) -> f64 {
        let unit = self.scale * 10_f64.powi(-(self.decimals() as i32));
        match rounding {
            Rounding::Cut if !self.digits.is_empty() => {
                self.value + (0.5 * unit).copysign(self.value)
            }
            _ => self.value,
        }
    }

    /// Another number in the same unit, with two digits more than are printed, and at least `least`
    /// digits.
    pub fn formatted_alike(&self, number: f64, least: usize) -> String {
        let digits = (self.significant_digits() + 2).max(least);
        match self.percent {
            true => format!("{} %", significant(100.0 * number, digits)),
            false => significant(number, digits),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn comes_out(text: &str, number: f64) -> [bool; 3] {
        let printed = Printed::read(text).expect("a number");
        Rounding::ALL.map(|rounding| printed.is_reproduced_by(number, rounding, None))
    }

    #[test]
    fn digits_are_those_of_the_number_rounded_or_cut() {
        for (text, number, expected) in [
            ("0.8478", 0.847_791, [true, false, true]),
            ("0.8478", 0.847_749, [false, false, false]),
            ("1.3537", 1.353_763, [false, true, true]),
            ("+0.99413", 0.994_138, [false, true, true]),
            ("-0.99414", -0.994_138, [true, false, true]),
            ("-0.99414", 0.994_138, [false, false, false]),
            ("0.58620", 0.586_2, [true, true, true]),
            ("0.00000", -0.0, [true, true, true]),
            (".5", 0.5, [true, true, true]),
            ("51", 51.2, [true, true, true]),
            ("9.258e-8", 9.2581e-8, [true, true, true]),
            ("9.258e-8", 9.2586e-8, [false, true, true]),
            ("1.49 %", 0.014_9, [true, true, true]),
            ("1.5 %", 0.014_9, [true, false, true]),
            ("3/2", 1.5, [true, true, true]),
            ("3/2", 1.500_001, [false, false, false]),
            ("0.5", f64::NAN, [false, false, false]),
        ] {
            assert_eq!(comes_out(text, number), expected, "{text}: {number}");
        }
    }

    #[test]
    fn bounds_and_tolerances() {
        let reproduced = |text: &str, number, tolerance| {
            let printed = Printed::read(text).expect("a number");
            printed.is_reproduced_by(number, Rounding::Rounded, tolerance)
        };
        assert!(reproduced("< 2 %", 0.019, None) && !reproduced("< 2 %", 0.02, None));
        assert!(reproduced("<= 2 %", 0.02, None) && reproduced(">= 0.01", 0.01, None));
        assert!(!reproduced("> 0.01", f64::NAN, None));
        assert!(reproduced("2", 2.1, Some(0.06)) && !reproduced("2", 2.1, Some(0.04)));
        let third = Rational::new(1.into(), 3.into());
        let exactly = |text: &str| {
            Printed::read(text)
                .is_some_and(|it| it.is_reproduced_exactly_by(&third, Rounding::Rounded, None))
        };
        assert!(
            exactly("1/3")
                && exactly("2/6")
                && exactly("0.33")
                && !exactly("33/100")
                && !exactly("0")
        );
    }

    #[test]
    fn what_is_no_number_is_refused() {
        for text in [
            "", "abc", "1.2.3", "1,5", "--1", "1/2/3", "1e", "e5", "5 kg", "1/2 %", "1e999", "< ",
            "%", "nan", "inf", "1.",
        ] {
            assert_eq!(Printed::read(text), None, "{text}");
        }
        assert_eq!(Printed::read("0.0340").map(|it| it.significant_digits()), Some(3));
    }
}

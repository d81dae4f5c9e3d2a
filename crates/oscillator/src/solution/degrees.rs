//! The degrees of the polynomials that an approximant is made of.

use std::fmt;

/// The degrees of an approximant, one for each of its polynomials.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::solution::Degrees;
///
/// assert_eq!(Degrees::Quotient(2, 1).to_string(), "[2/1]");
/// assert_eq!(Degrees::from_list(&[3, 2]), Some(Degrees::Quotient(3, 2)));
/// assert_eq!(Degrees::from_list(&[3]), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Degrees {
    /// The degrees of numerator and denominator.
    Quotient(u32, u32),
    /// The degrees of the coefficients P, Q and R of `P + Q f + R f^2`.
    Quadratic(u32, u32, u32),
}

impl Degrees {
    /// The degrees in a list; `None` for a list that no approximant has.
    pub fn from_list(list: &[u32]) -> Option<Self> {
        match *list {
            [numerator, denominator] => Some(Self::Quotient(numerator, denominator)),
            [p, q, r] => Some(Self::Quadratic(p, q, r)),
            _ => None,
        }
    }

    /// All degrees, in their order.
    pub fn list(self) -> Vec<u32> {
        match self {
            Self::Quotient(numerator, denominator) => vec![numerator, denominator],
            Self::Quadratic(p, q, r) => vec![p, q, r],
        }
    }

    /// The sum of the degrees.
    pub fn sum(self) -> u32 {
        self.list().into_iter().fold(0, u32::saturating_add)
    }

    /// The degrees as they are typed in an option: `2,1`.
    pub fn separated(self) -> String {
        self.joined(",")
    }

    fn joined(self, separator: &str) -> String {
        let degrees: Vec<String> = self.list().iter().map(u32::to_string).collect();
        degrees.join(separator)
    }
}

impl fmt::Display for Degrees {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "[{}]", self.joined("/"))
    }
}

//! Exact values of symbols, as a user gives them.
//!
//! In: names with numbers or multiples of pi, as text or one by one. Out: the same, exact or as
//! doubles; in the units of the equation. A value that is not a number, or a name that is given
//! twice, is a [`ValueError`].
//!
//! ```
//! # use lindstedt_expr as lindstedt;
//! use lindstedt::Values;
//!
//! let at: Values = "A = 3/2, eps = 1".parse()?;
//! assert_eq!(at.get("A".into()), Some(1.5));
//! # Ok::<(), lindstedt::ValueError>(())
//! ```

use std::collections::BTreeMap;
use std::str::FromStr;

use crate::exact::rational::to_f64;
use crate::expr::{Expr, parse_expression};
use crate::symbol::Symbol;

/// Exact values of symbols, as given by the user: numbers and multiples of pi.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values(BTreeMap<Symbol, Expr>);

/// The reason why a value is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ValueError {
    /// The value contains a symbol.
    #[error(
        "the value `{value}` of `{name}` contains `{symbol}`: give a number, such as 3/2 or pi/3"
    )]
    NotANumber {
        /// The name.
        name: Symbol,
        /// The value as typed.
        value: String,
        /// The symbol in it.
        symbol: Symbol,
    },
    /// The value is not finite.
    #[error("the value `{value}` of `{name}` is not a finite number")]
    NotFinite {
        /// The name.
        name: Symbol,
        /// The value as typed.
        value: String,
    },
    /// The name was given twice.
    #[error("`{0}` is given two values")]
    Twice(Symbol),
    /// Text that does not have the form `name = value`.
    #[error("`{0}` is no value: write a name and a number, such as A = 3/2")]
    Form(String),
}

impl Values {
    /// Adds the value of a symbol.
    ///
    /// # Errors
    /// A value with symbols in it, one that is not finite, or a second value for the same name.
    pub fn insert(&mut self, name: Symbol, value: Expr) -> Result<(), ValueError> {
        if let Some(symbol) = value.symbols().into_iter().next() {
            return Err(ValueError::NotANumber { name, value: value.to_string(), symbol });
        }
        if value.evaluate(&BTreeMap::new()).is_err() {
            return Err(ValueError::NotFinite { name, value: value.to_string() });
        }
        match self.0.insert(name, value) {
            None => Ok(()),
            Some(_) => Err(ValueError::Twice(name)),
        }
    }

    /// All values as floating-point numbers.
    pub fn numbers(&self) -> BTreeMap<Symbol, f64> {
        let known = |&name: &Symbol| Some((name, self.get(name)?));
        self.0.keys().filter_map(known).collect()
    }

    /// The names and exact values, in alphabetical order.
    pub fn iter(&self) -> impl Iterator<Item = (Symbol, &Expr)> {
        self.0.iter().map(|(name, value)| (*name, value))
    }

    /// The value of a symbol as a floating-point number.
    pub fn get(&self, name: Symbol) -> Option<f64> {
        let value = self.0.get(&name)?;
        value.as_number().map(to_f64).or_else(|| value.evaluate(&BTreeMap::new()).ok())
    }

    /// Splits the values into those of `names`, and the others.
    pub fn split(&self, names: &[Symbol]) -> (BTreeMap<Symbol, Expr>, Self) {
        let (those, others) =
            self.0.clone().into_iter().partition(|(name, _)| names.contains(name));
        (those, Self(others))
    }

    /// Whether nothing is given.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// All values as floating-point numbers, with this value added or replaced.
    pub fn with(&self, name: Symbol, value: f64) -> BTreeMap<Symbol, f64> {
        let mut numbers = self.numbers();
        numbers.insert(name, value);
        numbers
    }
}

/// Names with numbers, each the decimal that reads back to it: 0.1 is 1/10.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::Values;
///
/// assert_eq!(Values::try_from([("A", 1.5), ("eps", 0.1)])?, "A = 3/2, eps = 1/10".parse()?);
/// assert!(Values::try_from([("A", f64::NAN)]).is_err());
/// # Ok::<(), lindstedt::ValueError>(())
/// ```
impl<const N: usize> TryFrom<[(&str, f64); N]> for Values {
    type Error = ValueError;

    fn try_from(numbers: [(&str, f64); N]) -> Result<Self, ValueError> {
        let mut values = Self::default();
        for (name, number) in numbers {
            let name = Symbol::new(name);
            let value = parse_expression(&number.to_string());
            let not_finite = |_| ValueError::NotFinite { name, value: number.to_string() };
            values.insert(name, value.map_err(not_finite)?)?;
        }
        Ok(values)
    }
}

/// Reads names and values such as `A = 3/2, eps = 1`.
impl FromStr for Values {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Self, ValueError> {
        let mut values = Self::default();
        for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
            let form = || ValueError::Form(part.to_owned());
            let (name, value) = part.split_once('=').ok_or_else(form)?;
            let name =
                parse_expression(name).ok().and_then(|name| name.as_symbol()).ok_or_else(form)?;
            values.insert(name, parse_expression(value).map_err(|_| form())?)?;
        }
        Ok(values)
    }
}

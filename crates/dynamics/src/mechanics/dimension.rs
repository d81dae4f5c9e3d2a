//! Units of mechanics: the dimension of a quantity, and a check that the terms of an energy can be
//! added.
//!
//! ```text
//! [quantity] = kg^a m^b s^c        kg^a m^b s^c + kg^a m^b s^c, never anything else;   sin(1), H(any), sgn(any)
//! ```
//!
//! In: units as text, `"N*s/m^(3/2)"`, for every parameter and coordinate. Out: the [`Dimension`]
//! of an expression, or the term whose dimension is wrong. Angles are dimensionless: a radian is 1.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use num_traits::{One, Zero};
use thiserror::Error;

use super::{EquationsOfMotion, Mechanism};
use crate::exact::Rational;
use crate::expr::{Expr, ExprError, Function, Node, ParseError, parse_expression};
use crate::symbol::Symbol;

/// A dimension: the exponents of kilogram, metre and second.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Dimension([Rational; 3]);

/// The base units, in the order of the exponents.
const BASE: [&str; 3] = ["kg", "m", "s"];

/// Units that have names, by their exponents of kilogram, metre and second. Multiples such as
/// millimetres are not among them, because a check of dimensions could not see their factors.
const NAMED: [(&str, [i64; 3]); 12] = [
    ("1", [0, 0, 0]),
    ("rad", [0, 0, 0]),
    ("kg", [1, 0, 0]),
    ("m", [0, 1, 0]),
    ("s", [0, 0, 1]),
    ("Hz", [0, 0, -1]),
    ("N", [1, 1, -2]),
    ("Pa", [1, -1, -2]),
    ("J", [1, 2, -2]),
    ("W", [1, 2, -3]),
    ("kg_m2", [1, 2, 0]),
    ("N_m", [1, 2, -2]),
];

/// The reason why a unit or a term is refused.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum UnitError {
    /// The text of a unit has a syntax error.
    #[error("the unit of `{name}`: {error}")]
    Parse {
        /// The name of the symbol.
        name: String,
        /// The error of its syntax.
        error: Box<ParseError>,
    },
    /// A word is not a known unit.
    #[error("the unit of `{name}`: `{unit}` is no unit that is known here")]
    Unknown {
        /// The name of the symbol.
        name: String,
        /// The word.
        unit: String,
    },
    /// A unit is not a product of powers of units.
    #[error("the unit of `{name}`: `{unit}` is no product of powers of units")]
    NoProduct {
        /// The name of the symbol.
        name: String,
        /// The text.
        unit: String,
    },
    /// A parameter or a coordinate has no unit.
    #[error("`{0}` has no unit")]
    Missing(Symbol),
    /// A unit is given for a name that does not occur.
    #[error("there is a unit for `{0}`, which does not occur")]
    Unused(Symbol),
    /// A term has a dimension other than that of the other terms.
    #[error("in the {part} the term `{term}` has the unit {found}, where {expected} belongs")]
    Term {
        /// The part of the mechanism.
        part: String,
        /// The term.
        term: Expr,
        /// The unit of the term.
        found: String,
        /// The expected unit.
        expected: String,
    },
    /// The argument of a function such as `sin` has a dimension.
    #[error("in the {part} the function in `{term}` takes a number, not {found}")]
    Argument {
        /// The part of the mechanism.
        part: String,
        /// The function and its argument.
        term: Expr,
        /// The unit of the argument.
        found: String,
    },
    /// A base with a dimension has an exponent that is not a number, or an exponent has a
    /// dimension.
    #[error("in the {part} the power `{term}` has no unit: its base is measured in {found}")]
    Power {
        /// The part of the mechanism.
        part: String,
        /// The power.
        term: Expr,
        /// The unit of the base.
        found: String,
    },
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
}

impl UnitError {
    /// Returns advice on what to write instead; `None` if there is none.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Missing(name) => Some(format!(
                "give it in [units]: {name} = \"kg\", or \"1\" for a number or an angle; or leave [units] out"
            )),
            Self::Unknown { .. } | Self::NoProduct { .. } | Self::Parse { .. } => Some(
                "products and powers of kg, m, s, N, Pa, J, W, Hz, rad and 1, such as \"N*s/m^(5/2)\"; no multiples such as mm".to_owned(),
            ),
            _ => None,
        }
    }
}

impl Dimension {
    /// The dimension of a pure number.
    pub fn none() -> Self {
        Self::default()
    }

    /// The dimension with these whole exponents of kilogram, metre and second.
    pub fn from_exponents(exponents: [i64; 3]) -> Self {
        Self(exponents.map(|exponent| Rational::from_integer(exponent.into())))
    }

    /// Whether the quantity is a pure number.
    pub fn is_none(&self) -> bool {
        self.0.iter().all(Zero::is_zero)
    }

    /// The dimension of a product.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        let mut product = self.clone();
        product.0.iter_mut().zip(&other.0).for_each(|(exponent, other)| *exponent += other);
        product
    }

    /// The dimension of a power.
    #[must_use]
    pub fn power(&self, exponent: &Rational) -> Self {
        let mut power = self.clone();
        power.0.iter_mut().for_each(|own| *own *= exponent);
        power
    }

    /// The exponents of kilogram, metre and second.
    pub fn exponents(&self) -> &[Rational; 3] {
        &self.0
    }
}

impl fmt::Display for Dimension {
    /// Writes `kg m^2/s^2`; `1` for a pure number.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let write = |sign: bool| -> Vec<String> {
            let units = BASE.iter().zip(&self.0);
            let units = units.filter(|(_, exponent)| {
                !exponent.is_zero() && (**exponent > Rational::zero()) == sign
            });
            let unit = |(name, exponent): (&&str, &Rational)| {
                let exponent = if sign { exponent.clone() } else { -exponent.clone() };
                match (exponent.is_one(), exponent.is_integer()) {
                    (true, _) => (*name).to_owned(),
                    (false, true) => format!("{name}^{exponent}"),
                    (false, false) => format!("{name}^({exponent})"),
                }
            };
            units.map(unit).collect()
        };
        let (above, below) = (write(true), write(false));
        formatter.write_str(&if above.is_empty() { "1".to_owned() } else { above.join(" ") })?;
        match below.as_slice() {
            [] => Ok(()),
            [only] => write!(formatter, "/{only}"),
            several => write!(formatter, "/({})", several.join(" ")),
        }
    }
}

impl FromStr for Dimension {
    type Err = UnitError;

    /// Reads `"N*s/m^(3/2)"`, or with spaces for products as `Display` writes it.
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let name = || text.to_owned();
        let typed: Vec<&str> = text.split_whitespace().collect();
        let with_signs = typed.join("*").replace("*/*", "/").replace("*/", "/").replace("/*", "/");
        let expression = parse_expression(&with_signs)
            .map_err(|error| UnitError::Parse { name: name(), error: Box::new(error) })?;
        let mut units = BTreeMap::new();
        for symbol in expression.symbols() {
            let Some((_, exponents)) = NAMED.iter().find(|(named, _)| *named == symbol.name())
            else {
                return Err(UnitError::Unknown { name: name(), unit: symbol.name().to_owned() });
            };
            units.insert(symbol, Self::from_exponents(*exponents));
        }
        let no_product = UnitError::NoProduct { name: name(), unit: text.to_owned() };
        let (number, _) = expression.factors();
        match expression.node() {
            Node::Sum(_) | Node::Function(..) => Err(no_product),
            _ if !number.is_one() => Err(no_product),
            _ => dimension(&expression, &units, "unit").map_err(|_| no_product),
        }
    }
}

/// Returns the dimension of an expression; every symbol in it must have a unit.
///
/// # Errors
/// [`UnitError`] names the term; `part` is the part of the mechanism that contains it, for the
/// message.
pub fn dimension(
    expression: &Expr,
    units: &BTreeMap<Symbol, Dimension>,
    part: &str,
) -> Result<Dimension, UnitError> {
    let part = || part.to_owned();
    expression.fold(|expr, below: &[Dimension]| match expr.node() {
        Node::Number(_) | Node::Pi => Ok(Dimension::none()),
        Node::Symbol(name) => units.get(name).cloned().ok_or(UnitError::Missing(*name)),
        Node::Sum(terms) => odd_one_out(terms, below, &part()),
        Node::Product(..) => {
            Ok(below.iter().fold(Dimension::none(), |product, factor| product.times(factor)))
        }
        Node::Power(_, exponent) => match (below, exponent.as_number()) {
            ([base, _], Some(number)) => Ok(base.power(number)),
            ([base, exponent], None) if base.is_none() && exponent.is_none() => {
                Ok(Dimension::none())
            }
            _ => Err(UnitError::Power {
                part: part(),
                term: expr.clone(),
                found: below.first().cloned().unwrap_or_default().to_string(),
            }),
        },
        Node::Function(Function::Absolute, _) => Ok(below.first().cloned().unwrap_or_default()),
        Node::Function(Function::Sign | Function::Step, _) => Ok(Dimension::none()),
        // Zero is zero in any unit.
        Node::Function(Function::Maximum | Function::Minimum, arguments) => {
            let kept = arguments.iter().zip(below).filter(|(argument, _)| !argument.is_zero());
            let (arguments, below): (Vec<Expr>, Vec<Dimension>) =
                kept.map(|(one, other)| (one.clone(), other.clone())).unzip();
            odd_one_out(&arguments, &below, &part())
        }
        Node::Function(..) => match below.iter().find(|argument| !argument.is_none()) {
            None => Ok(Dimension::none()),
            Some(found) => Err(UnitError::Argument {
                part: part(),
                term: expr.clone(),
                found: found.to_string(),
            }),
        },
    })
}

/// Returns the common dimension of all terms; the error names the first term that differs from the
/// most frequent dimension.
fn odd_one_out(terms: &[Expr], found: &[Dimension], part: &str) -> Result<Dimension, UnitError> {
    let votes = |dimension: &Dimension| found.iter().filter(|other| *other == dimension).count();
    let expected =
        found.iter().rev().max_by_key(|dimension| votes(dimension)).cloned().unwrap_or_default();
    match terms.iter().zip(found).find(|(_, found)| **found != expected) {
        None => Ok(expected),
        Some((term, found)) => Err(UnitError::Term {
            part: part.to_owned(),
            term: term.clone(),
            found: found.to_string(),
            expected: expected.to_string(),
        }),
    }
}

/// Checks that every term of an expanded sum has the dimension `expected`.
///
/// # Errors
/// [`UnitError`] names the first term that has not.
pub fn check(
    expression: &Expr,
    expected: &Dimension,
    units: &BTreeMap<Symbol, Dimension>,
    part: &str,
) -> Result<(), UnitError> {
    let written_out = expression.expand()?;
    for term in written_out.terms().iter().filter(|term| !term.is_zero()) {
        let found = dimension(term, units, part)?;
        if found != *expected {
            return Err(UnitError::Term {
                part: part.to_owned(),
                term: term.clone(),
                found: found.to_string(),
                expected: expected.to_string(),
            });
        }
    }
    Ok(())
}

impl Mechanism {
    /// Returns the given units of parameters and coordinates, together with those of velocities,
    /// accelerations and time.
    pub fn all_units(&self, units: &BTreeMap<Symbol, Dimension>) -> BTreeMap<Symbol, Dimension> {
        let per_second = Dimension::from_exponents([0, 0, -1]);
        let mut all = units.clone();
        all.insert(Symbol::new("t"), Dimension::from_exponents([0, 0, 1]));
        for coordinate in &self.coordinates {
            let Some(own) = units.get(coordinate) else {
                continue;
            };
            let velocity = own.times(&per_second);
            all.insert(coordinate.derivative().derivative(), velocity.times(&per_second));
            all.insert(coordinate.derivative(), velocity);
        }
        all
    }

    /// Checks every term of the energies, the dissipation and the forces.
    ///
    /// # Errors
    /// [`UnitError`] for a name without a unit, or the first term with a dimension other than that
    /// of its part.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::mechanics::{Dimension, Mechanism};
    ///
    /// let slip = Mechanism::parse(&["x"], "m*L^2*x'^2/2", "m*g*(1 - cos(x))")?;
    /// let units = [("m", "kg"), ("L", "m"), ("g", "m/s^2"), ("x", "rad")];
    /// let units = units.map(|(name, unit)| (name.into(), unit.parse::<Dimension>().expect("a unit")));
    /// let refused = slip.check_units(&units.into()).unwrap_err();
    /// assert_eq!(refused.to_string(), "in the potential energy the term `g*m` has the unit kg m/s^2, where kg m^2/s^2 belongs");
    /// # Ok::<(), lindstedt::mechanics::MechanicsError>(())
    /// ```
    pub fn check_units(&self, units: &BTreeMap<Symbol, Dimension>) -> Result<(), UnitError> {
        let parameters = self.parameters();
        let mut needed = self.coordinates.iter().chain(&parameters);
        if let Some(missing) = needed.find(|name| !units.contains_key(name)) {
            return Err(UnitError::Missing(*missing));
        }
        let known = |name: &&Symbol| !self.coordinates.contains(name) && !parameters.contains(name);
        if let Some(unused) = units.keys().find(known) {
            return Err(UnitError::Unused(*unused));
        }
        let all = self.all_units(units);
        let energy = Dimension::from_exponents([1, 2, -2]);
        let power = Dimension::from_exponents([1, 2, -3]);
        check(&self.kinetic, &energy, &all, "kinetic energy")?;
        check(&self.potential, &energy, &all, "potential energy")?;
        check(&self.dissipation, &power, &all, "dissipation")?;
        let minus_one = -Rational::one();
        for (on, force) in &self.forces {
            let Some(own) = units.get(on) else { continue };
            check(force, &energy.times(&own.power(&minus_one)), &all, &format!("force on {on}"))?;
        }
        Ok(())
    }
}

impl EquationsOfMotion {
    /// Checks every term of the printed equations against the others of its equation.
    ///
    /// # Errors
    /// [`UnitError`] for the first term of another dimension; if the energies passed their check,
    /// this is an error in the derivation.
    pub fn check_units(&self, all_units: &BTreeMap<Symbol, Dimension>) -> Result<(), UnitError> {
        for left in &self.left {
            let written_out = left.expand()?;
            let Some(first) = written_out.terms().first() else {
                continue;
            };
            let expected = dimension(first, all_units, "equation of motion")?;
            check(&written_out, &expected, all_units, "equation of motion")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_read_and_print() {
        for (typed, printed) in [
            ("kg", "kg"),
            ("N", "kg m/s^2"),
            ("N*s/m^(5/2)", "kg/(m^(3/2) s)"),
            ("kg m^2/s^2", "kg m^2/s^2"),
            ("1", "1"),
            ("rad/s", "1/s"),
            ("Pa*m^2", "kg m/s^2"),
            ("1/s", "1/s"),
        ] {
            let dimension: Dimension = typed.parse().unwrap();
            assert_eq!(dimension.to_string(), printed, "{typed}");
            assert_eq!(dimension.to_string().parse::<Dimension>().unwrap(), dimension);
        }
        for wrong in ["mm", "kg + m", "3*kg", "sin(kg)", "kg^m", "", "kg*"] {
            assert!(wrong.parse::<Dimension>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_term_of_another_unit_is_named() {
        let units: BTreeMap<Symbol, Dimension> =
            [("L", "m"), ("g", "m/s^2"), ("m", "kg"), ("v", "m/s")]
                .map(|(name, unit)| (Symbol::new(name), unit.parse().unwrap()))
                .into();
        let of = |text: &str| {
            dimension(&text.parse().unwrap(), &units, "sum").map(|found| found.to_string())
        };
        assert_eq!(of("m*v^2/2 + m*g*L").unwrap(), "kg m^2/s^2");
        assert_eq!(of("sqrt(g/L)").unwrap(), "1/s");
        assert_eq!(of("max(L, v^2/g)").unwrap(), "m");
        assert_eq!(of("H(L)*abs(v)").unwrap(), "m/s");
        let message = of("m*g*L + m*v^2 + m*v").unwrap_err().to_string();
        assert!(
            message.contains("`m*v` has the unit kg m/s, where kg m^2/s^2 belongs"),
            "{message}"
        );
        let message = of("sin(L)").unwrap_err().to_string();
        assert!(message.contains("takes a number, not m"), "{message}");
        assert!(of("2^L").is_err() && of("q").is_err());
    }
}

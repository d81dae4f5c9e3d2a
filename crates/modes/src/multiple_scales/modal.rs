//! The linear modes of a system in which each divisor is a number or has a name.
//!
//! ```text
//! q = V eta,   P (M q'' + K q) = eta'' + diag(omega_j^2) eta
//! ```
//!
//! Coordinates that masses and springs do not couple are modes themselves, in their order. A
//! frequency is a product of powers, or a name whose square is known: even powers of it are replaced,
//! so that equal coefficients look alike.

use std::collections::BTreeMap;

use num_traits::{One, Signed, Zero};

use super::answer::KEPT_DIGITS;
use super::{CoupledSystem, MultipleScalesError, NearDivisor};
use crate::decimal::{rounded_fraction, significant};
use crate::exact::polynomial::Monomial;
use crate::exact::rational::{from_f64, to_f64};
use crate::exact::{Polynomial, Rational};
use crate::expr::Expr;
use crate::modes::ModeError;
use crate::modes::linear::{DIGITS, LinearModes, tidied};
use crate::solution::Definition;
use crate::symbol::{Symbol, fresh};

/// The linear modes and the names that they introduce.
#[derive(Clone, Debug)]
pub(super) struct ModalForm {
    /// V, a row for each coordinate.
    pub(super) shapes: Vec<Vec<Polynomial>>,
    /// P, a row for each mode.
    pub(super) projection: Vec<Vec<Polynomial>>,
    /// `omega_j`.
    pub(super) frequencies: Vec<Frequency>,
    pub(super) names: FormulaNames,
    /// Whether coefficients are rounded to [`DIGITS`] digits.
    pub(super) rounded: bool,
    /// The waves that are near the frequency of a mode.
    pub(super) near: Vec<NearDivisor>,
}

/// A frequency, as a polynomial of one term.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Frequency {
    /// Its value in the names.
    pub(super) value: Polynomial,
    /// The number that it is, where no letters stand in it.
    pub(super) number: Option<f64>,
}

/// Names of what stands in formulas, and the squares that are known of them.
#[derive(Clone, Debug, Default)]
pub(super) struct FormulaNames {
    pub(super) taken: Vec<Symbol>,
    pub(super) definitions: Vec<Definition>,
    squares: BTreeMap<Symbol, Polynomial>,
}

impl FormulaNames {
    /// A new name.
    pub(super) fn define(&mut self, wanted: &str, meaning: Expr) -> Symbol {
        let known = self.definitions.iter().find(|known| known.meaning == meaning);
        if let Some(known) = known {
            return known.symbol;
        }
        let symbol = fresh(wanted, &self.taken);
        self.taken.push(symbol);
        self.definitions.push(Definition { symbol, meaning });
        symbol
    }

    /// A polynomial as a single term: itself, or a name.
    pub(super) fn single(&mut self, polynomial: &Polynomial, wanted: &str) -> Polynomial {
        match polynomial.single_term() {
            Some(_) => polynomial.clone(),
            None => {
                // Numbers of more digits are those of rounding.
                const LONGEST: u64 = 160;
                let long = |number: &Rational| number.denom().bits() > LONGEST;
                let meaning = polynomial.map(|number| match long(number) {
                    true => rounded_fraction(number, KEPT_DIGITS),
                    false => number.clone(),
                });
                Polynomial::symbol(self.define(wanted, Expr::from(&meaning)))
            }
        }
    }

    /// The inverse of a polynomial that is not zero; a sum gets a name first.
    pub(super) fn inverse(&mut self, polynomial: &Polynomial, wanted: &str) -> Option<Polynomial> {
        if polynomial.is_zero() {
            return None;
        }
        if let Some(inverse) = self.inverse_beside_root(polynomial) {
            return Some(inverse);
        }
        self.single(polynomial, wanted).power(-1)
    }

    /// `1/(p + q w) = (p - q w)/(p^2 - q^2 w^2)` of numbers p and q and a root w whose square is one;
    /// `None` of anything else.
    fn inverse_beside_root(&self, polynomial: &Polynomial) -> Option<Polynomial> {
        let mut roots = polynomial.symbols().into_iter();
        let (root, None) = (roots.next()?, roots.next()) else { return None };
        let square = self.squares.get(&root)?.as_number()?;
        let mut conjugate = Polynomial::zero();
        let mut norm = Rational::zero();
        for (monomial, number) in polynomial.terms() {
            match monomial.exponent(root) {
                0 => norm += number * number,
                1 => norm -= number * number * &square,
                _ => return None,
            }
            let sign =
                if monomial.exponent(root) == 0 { Rational::one() } else { -Rational::one() };
            conjugate.add_term(monomial.clone(), number * sign);
        }
        (!norm.is_zero()).then(|| conjugate.product(&Polynomial::constant(norm.recip())))
    }

    /// A polynomial with known squares in place of even powers.
    pub(super) fn reduced(&self, polynomial: &Polynomial) -> Polynomial {
        let mut reduced = polynomial.clone();
        for (name, square) in &self.squares {
            if !reduced.exponent_range(*name).is_some_and(|(low, high)| low < 0 || high > 1) {
                continue;
            }
            let mut result = Polynomial::zero();
            for (monomial, number) in reduced.terms() {
                let exponent = monomial.exponent(*name);
                let rest = monomial
                    .without(*name)
                    .product(&Monomial::power_of(*name, exponent.rem_euclid(2)));
                let term = Polynomial::term(rest, number.clone());
                match square.power(exponent.div_euclid(2)) {
                    Some(power) => result.accumulate(&term.product(&power)),
                    None => result.add_term(monomial.clone(), number.clone()),
                }
            }
            reduced = result;
        }
        reduced
    }
}

/// The square root of a positive fraction to [`DIGITS`] digits; whether it is exact.
fn root(square: &Rational) -> (Rational, bool) {
    let exact = Polynomial::constant(square.clone()).single_term_root();
    if let Some(exact) = exact.and_then(|root| root.as_number()) {
        return (exact, true);
    }
    /// Newton's method doubles the fifteen digits of the start each time.
    const STEPS: usize = 4;
    let half = Rational::new(1.into(), 2.into());
    let mut found = from_f64(to_f64(square).sqrt()).unwrap_or_else(Rational::one);
    for _ in 0..STEPS {
        found = rounded_fraction(&((&found + square / &found) * &half), DIGITS + 10);
    }
    (rounded_fraction(&found, DIGITS), false)
}

impl ModalForm {
    /// The modes of a system.
    ///
    /// # Errors
    /// [`ModeError`] for modes that do not oscillate, or have no closed form.
    pub(super) fn new(system: &CoupledSystem) -> Result<Self, MultipleScalesError> {
        let mut names = FormulaNames {
            taken: system.names(),
            definitions: system.constants.clone(),
            squares: BTreeMap::new(),
        };
        let count = system.mass.len();
        let is_diagonal = |rows: &[Vec<Polynomial>]| {
            (0..count).all(|i| (0..count).all(|j| i == j || rows[i][j].is_zero()))
        };
        if is_diagonal(&system.mass) && is_diagonal(&system.stiffness) {
            return Self::of_diagonal(system, names);
        }
        let modes = LinearModes::new(&system.mass, &system.stiffness, system.names())?;
        names.taken.extend(modes.definitions().iter().map(|definition| definition.symbol));
        names.definitions.extend_from_slice(modes.definitions());
        let rounded = (0..count).any(|index| modes.is_rounded(index));
        let mut form = Self {
            shapes: vec![vec![Polynomial::zero(); count]; count],
            projection: vec![],
            frequencies: vec![],
            names,
            rounded,
            near: vec![],
        };
        for index in 0..count {
            let mode = modes.mode_of_basis(index)?;
            for (row, entry) in form.shapes.iter_mut().zip(&mode.shape) {
                row[index] = entry.clone();
            }
            let left = mode.left.iter().map(|entry| entry.product(&mode.inverse_mass));
            form.projection.push(left.collect());
            let frequency = form.frequency(&mode.square, index + 1, rounded)?;
            form.frequencies.push(frequency);
        }
        Ok(form)
    }

    fn of_diagonal(
        system: &CoupledSystem,
        names: FormulaNames,
    ) -> Result<Self, MultipleScalesError> {
        let count = system.mass.len();
        let zeros = || vec![vec![Polynomial::zero(); count]; count];
        let mut form = Self {
            shapes: zeros(),
            projection: zeros(),
            frequencies: vec![],
            names,
            rounded: false,
            near: vec![],
        };
        for index in 0..count {
            let number = index + 1;
            let (mass, stiffness) = (&system.mass[index][index], &system.stiffness[index][index]);
            let inverse =
                form.names.inverse(mass, &format!("m{number}")).ok_or(ModeError::Massless)?;
            form.shapes[index][index] = Polynomial::constant(Rational::one());
            if stiffness.is_zero() {
                return Err(ModeError::NoStiffness { number }.into());
            }
            form.projection[index][index] = inverse.clone();
            let square = stiffness.product(&inverse);
            let frequency = form.frequency(&square, number, false)?;
            form.frequencies.push(frequency);
        }
        Ok(form)
    }

    /// The frequency with this square.
    fn frequency(
        &mut self,
        square: &Polynomial,
        number: usize,
        rounded: bool,
    ) -> Result<Frequency, MultipleScalesError> {
        if let Some(value) = square.as_number() {
            if !value.is_positive() {
                let square = significant(to_f64(&value), 6);
                return Err(ModeError::Unstable { number, square }.into());
            }
            let (frequency, exact) = root(&value);
            let number_of = Some(to_f64(&frequency));
            if exact || rounded {
                return Ok(Frequency { value: Polynomial::constant(frequency), number: number_of });
            }
            let meaning = Expr::number(value).sqrt()?;
            let name = self.names.define(&format!("omega{number}"), meaning);
            self.names.squares.insert(name, square.clone());
            return Ok(Frequency { value: Polynomial::symbol(name), number: number_of });
        }
        if let Some(root) = square.single_term_root() {
            let named = root.symbols().into_iter().next();
            let meaning = self.names.definitions.iter().find(|known| Some(known.symbol) == named);
            let number = meaning.and_then(|known| known.meaning.evaluate(&Default::default()).ok());
            return Ok(Frequency { value: root, number });
        }
        let meaning = Expr::from(square).sqrt()?;
        let value = meaning.evaluate(&Default::default()).ok();
        let name = self.names.define(&format!("omega{number}"), meaning);
        if square.single_term().is_some() {
            self.names.squares.insert(name, square.clone());
        }
        Ok(Frequency { value: Polynomial::symbol(name), number: value })
    }

    /// A polynomial in one look: with known squares, and with as many digits as are kept.
    pub(super) fn tidied(&self, polynomial: &Polynomial) -> Polynomial {
        let reduced = self.names.reduced(polynomial);
        match self.rounded {
            false => reduced,
            true => reduced.map(|number| tidied(number, false)),
        }
    }

    /// Whether a polynomial is zero, or as small as rounding leaves it.
    pub(super) fn is_zero(&self, polynomial: &Polynomial) -> bool {
        const NEGLIGIBLE: f64 = 1e-40;
        polynomial.is_zero()
            || (self.rounded
                && polynomial.terms().all(|(_, number)| to_f64(&number.abs()) < NEGLIGIBLE))
    }
}

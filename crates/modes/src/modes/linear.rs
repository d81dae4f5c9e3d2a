//! Linear modes: `(K - lambda M) v = 0`, `(K - lambda M)^T u = 0`, with `lambda = omega^2`.
//!
//! (L. Meirovitch, *Fundamentals of Vibrations*, 2001, section 7.2.) Of numbers the roots of
//! `det(K - lambda M)` are isolated exactly; a root that is a fraction gives an exact mode, any other
//! one a mode of [`DIGITS`] digits. Of two coordinates with letters the roots are closed:
//!
//! ```text
//! det M lambda^2 - b lambda + det K = 0,    b = K11 M22 + K22 M11 - K12 M21 - K21 M12
//! v = (1, r),  r = -(K11 - lambda M11)/(K12 - lambda M12)
//! ```

use num_traits::{One, Signed, Zero};

use super::ModeError;
use super::expansion::Basis;
use super::matrix::{self, Matrix};
use crate::decimal::{rounded_fraction, significant, significant_fraction};
use crate::exact::rational::{from_f64, ratio, to_f64};
use crate::exact::real_roots::{derivative, positive_roots, remainder};
use crate::exact::{Polynomial, Rational};
use crate::expr::{Expr, ExprError};
use crate::solution::Definition;
use crate::symbol::{Symbol, fresh};

/// Number of digits of a root that is no fraction.
pub(crate) const DIGITS: usize = 60;

/// A linear mode that oscillates.
#[derive(Clone, Debug)]
pub(crate) struct LinearMode {
    /// lambda, the square of the linear frequency.
    pub(crate) square: Polynomial,
    /// v, whose first entry that is not zero is one.
    pub(crate) shape: Vec<Polynomial>,
    /// u, likewise.
    pub(crate) left: Vec<Polynomial>,
    /// `1/(u^T M v)`.
    pub(crate) inverse_mass: Polynomial,
}

/// A frequency that is near a multiple of that of a mode: the divisor is small.
#[derive(Clone, Debug, PartialEq)]
pub struct NearResonance {
    /// The number of the mode whose frequency it is.
    pub other: usize,
    /// The multiple.
    pub ratio: usize,
    /// The square of that frequency over the square of the multiple, minus one.
    pub distance: f64,
}

/// The linear modes of a system.
#[derive(Clone, Debug)]
pub(crate) enum LinearModes {
    /// The modes of matrices of numbers.
    Numbers(NumberModes),
    /// The modes of two coordinates, in closed form.
    Two(Box<TwoModes>),
}

/// A whole number.
pub(crate) fn whole(value: i64) -> Polynomial {
    Polynomial::constant(ratio(value, 1))
}

/// The unit vector of two along one of them.
pub(crate) fn unit(along: usize) -> Vec<Polynomial> {
    [0, 1].map(|index| whole((index == along).into())).to_vec()
}

/// The linear modes of matrices of numbers.
#[derive(Clone, Debug)]
pub(crate) struct NumberModes {
    pub(crate) mass: Matrix,
    pub(crate) stiffness: Matrix,
    /// The roots lambda, smallest first, each as often as it counts.
    pub(crate) roots: Vec<Root>,
}

/// A root lambda.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Root {
    pub(crate) value: Rational,
    /// Whether it is that fraction, and not rounded.
    pub(crate) exact: bool,
}

/// The linear modes of two coordinates in closed form.
#[derive(Clone, Debug)]
pub(crate) struct TwoModes {
    pub(crate) modes: [LinearMode; 2],
    /// lambda in the letters of the equations, where it is a sum of products of powers.
    pub(crate) explicit: [Option<Polynomial>; 2],
    /// lambda where no letters stand in it.
    values: [Option<f64>; 2],
    /// The names of frequencies, shapes and masses.
    pub(crate) definitions: Vec<Definition>,
}

impl LinearModes {
    /// The linear modes of mass and stiffness matrices; `taken` are the names in use.
    ///
    /// # Errors
    /// [`ModeError`] for a singular mass matrix, roots that are not real, and letters that leave no
    /// closed form.
    pub(crate) fn new(
        mass: &[Vec<Polynomial>],
        stiffness: &[Vec<Polynomial>],
        taken: Vec<Symbol>,
    ) -> Result<Self, ModeError> {
        let numbers = |rows: &[Vec<Polynomial>]| -> Option<Matrix> {
            rows.iter().map(|row| row.iter().map(Polynomial::as_number).collect()).collect()
        };
        match (numbers(mass), numbers(stiffness)) {
            (Some(mass), Some(stiffness)) => Ok(Self::Numbers(NumberModes::new(mass, stiffness)?)),
            _ if mass.len() == 2 => Ok(Self::Two(Box::new(TwoModes::new(mass, stiffness, taken)?))),
            _ => {
                let entries = mass.iter().chain(stiffness).flatten();
                let mut letters: Vec<Symbol> = entries.flat_map(Polynomial::symbols).collect();
                letters.sort_unstable();
                letters.dedup();
                Err(ModeError::Letters { coordinates: mass.len(), letters })
            }
        }
    }

    /// The mode of this index.
    ///
    /// # Errors
    /// [`ModeError`] for a mode that does not oscillate, or is not the only one of its frequency.
    pub(crate) fn mode(&self, index: usize) -> Result<LinearMode, ModeError> {
        match self {
            Self::Numbers(modes) => modes.mode(index),
            Self::Two(modes) => modes.mode(index),
        }
    }

    /// The mode of this index, where those of one frequency may be any basis of their shapes, each
    /// independent of the others in mass and stiffness.
    ///
    /// # Errors
    /// [`ModeError`] for a mode that does not oscillate, and for shapes that are fewer than the modes.
    pub(crate) fn mode_of_basis(&self, index: usize) -> Result<LinearMode, ModeError> {
        match self {
            Self::Numbers(modes) => modes.mode_of_basis(index),
            Self::Two(modes) => modes.mode(index),
        }
    }

    /// The number of modes.
    pub(crate) fn count(&self) -> usize {
        match self {
            Self::Numbers(modes) => modes.roots.len(),
            Self::Two(modes) => modes.modes.len(),
        }
    }

    /// The frequencies of other modes that are near a multiple of that of this mode.
    pub(crate) fn near_resonances(&self, index: usize, highest: usize) -> Vec<NearResonance> {
        /// Largest relative distance of the squares of two frequencies that are near each other.
        const NEAR: f64 = 0.1;
        let Self::Numbers(modes) = self else { return vec![] };
        let own = to_f64(&modes.roots[index].value);
        let mut found = Vec::new();
        for (other, root) in modes.roots.iter().enumerate().filter(|(other, _)| *other != index) {
            for ratio in (2..=highest).chain([1]) {
                let distance = to_f64(&root.value) / (own * (ratio * ratio) as f64) - 1.0;
                if distance != 0.0 && distance.abs() < NEAR {
                    found.push(NearResonance { other: other + 1, ratio, distance });
                }
            }
        }
        found
    }

    /// Whether the mode of this index has rounded numbers.
    pub(crate) fn is_rounded(&self, index: usize) -> bool {
        match self {
            Self::Numbers(modes) => !modes.roots[index].exact,
            Self::Two(_) => false,
        }
    }

    /// The unknowns in which a mode is expanded.
    pub(crate) fn basis(&self, index: usize, mode: &LinearMode, mass: &[Vec<Polynomial>]) -> Basis {
        let scaled = |left: &[Polynomial], factor: &Polynomial| -> Vec<Polynomial> {
            left.iter().map(|entry| entry.product(factor)).collect()
        };
        match self {
            Self::Numbers(modes) => {
                let count = modes.roots.len();
                let unit: Vec<Vec<Polynomial>> = (0..count)
                    .map(|row| (0..count).map(|column| whole((row == column).into())).collect())
                    .collect();
                Basis {
                    coordinates: unit.clone(),
                    projection: unit,
                    mass: mass.to_vec(),
                    stiffness: modes
                        .stiffness
                        .iter()
                        .map(|row| row.iter().cloned().map(Polynomial::constant).collect())
                        .collect(),
                    shape: mode.shape.clone(),
                    left: scaled(&mode.left, &mode.inverse_mass),
                }
            }
            Self::Two(modes) => {
                let [first, second] = &modes.modes;
                Basis {
                    coordinates: [0, 1]
                        .map(|row| vec![first.shape[row].clone(), second.shape[row].clone()])
                        .to_vec(),
                    projection: [first, second]
                        .map(|mode| scaled(&mode.left, &mode.inverse_mass))
                        .to_vec(),
                    mass: [unit(0), unit(1)].to_vec(),
                    stiffness: [0, 1]
                        .map(|index| {
                            let square = &modes.modes[index].square;
                            unit(index).iter().map(|entry| entry.product(square)).collect()
                        })
                        .to_vec(),
                    shape: unit(index),
                    left: unit(index),
                }
            }
        }
    }

    /// The names that the modes introduce.
    pub(crate) fn definitions(&self) -> &[Definition] {
        match self {
            Self::Numbers(_) => &[],
            Self::Two(modes) => &modes.definitions,
        }
    }
}

impl NumberModes {
    fn new(mass: Matrix, stiffness: Matrix) -> Result<Self, ModeError> {
        if matrix::determinant(&mass).is_zero() {
            return Err(ModeError::Massless);
        }
        let polynomial = characteristic_polynomial(&mass, &stiffness);
        let zeros = polynomial.iter().take_while(|coefficient| coefficient.is_zero()).count();
        let rest = &polynomial[zeros..];
        let mirrored: Vec<Rational> = rest
            .iter()
            .enumerate()
            .map(|(power, number)| if power % 2 == 1 { -number } else { number.clone() })
            .collect();
        let mut roots = Vec::new();
        for (negative, polynomial) in [(true, mirrored.as_slice()), (false, rest)] {
            for root in positive_roots(polynomial) {
                let exact = root.exact.is_some();
                let value = root.exact.unwrap_or_else(|| refined(root.value, &root.factor));
                let times = if root.simple { 1 } else { multiplicity(polynomial, &root.factor) };
                let value = if negative { -value } else { value };
                roots.extend(std::iter::repeat_n(Root { value, exact }, times));
            }
        }
        roots.extend(std::iter::repeat_n(Root { value: Rational::zero(), exact: true }, zeros));
        roots.sort_by(|one, other| one.value.cmp(&other.value));
        match roots.len() == mass.len() {
            true => Ok(Self { mass, stiffness, roots }),
            false => Err(ModeError::NotReal),
        }
    }

    fn mode(&self, index: usize) -> Result<LinearMode, ModeError> {
        let Root { value, .. } = &self.roots[index];
        let equal = self
            .roots
            .iter()
            .enumerate()
            .find(|(other, root)| *other != index && root.value == *value);
        match equal {
            Some((other, _)) if value.is_positive() => {
                // One that has fewer shapes than modes is defective.
                self.mode_of_basis(index)?;
                let (number, other, square) = (index + 1, other + 1, self.square_in_words(index));
                Err(ModeError::EqualFrequencies { number, other, square })
            }
            _ => self.mode_of_basis(index),
        }
    }

    /// The square of a frequency, for messages.
    fn square_in_words(&self, index: usize) -> String {
        match &self.roots[index] {
            Root { value, exact: true } => value.to_string(),
            Root { value, exact: false } => significant_fraction(value, 6),
        }
    }

    fn mode_of_basis(&self, index: usize) -> Result<LinearMode, ModeError> {
        let number = index + 1;
        let Root { value, exact } = &self.roots[index];
        if value.is_negative() {
            return Err(ModeError::Unstable { number, square: self.square_in_words(index) });
        }
        if value.is_zero() {
            return Err(ModeError::NoStiffness { number });
        }
        let equal: Vec<usize> =
            (0..self.roots.len()).filter(|other| self.roots[*other].value == *value).collect();
        let place = equal.iter().position(|other| *other == index).unwrap_or(0);
        let singular = self.matrix_at(value);
        let tidy = |entry: &Rational| tidied(entry, *exact);
        let transposed = matrix::transposed(&singular);
        let shapes = matrix::null_vectors(&singular, equal.len(), &tidy);
        let lefts = matrix::null_vectors(&transposed, equal.len(), &tidy);
        let all_vanish = |of: &Matrix, vectors: &[Vec<Rational>]| {
            vectors.iter().all(|vector| matrix::vanishes(of, vector))
        };
        if equal.len() > 1 && !(all_vanish(&singular, &shapes) && all_vanish(&transposed, &lefts)) {
            return Err(ModeError::Defective { square: self.square_in_words(index) });
        }
        let (shape, left, mass) = self
            .independent(shapes, lefts, place, &tidy)
            .ok_or_else(|| ModeError::Defective { square: self.square_in_words(index) })?;
        let constants =
            |vector: Vec<Rational>| vector.into_iter().map(Polynomial::constant).collect();
        Ok(LinearMode {
            square: Polynomial::constant(value.clone()),
            shape: constants(shape),
            left: constants(left),
            inverse_mass: Polynomial::constant(mass.recip()),
        })
    }

    /// The pair at this place of shapes and left shapes that the mass matrix makes orthogonal to those
    /// before it, by the method of Gram and Schmidt, and their product with it; `None` where that vanishes.
    fn independent(
        &self,
        shapes: Vec<Vec<Rational>>,
        lefts: Vec<Vec<Rational>>,
        place: usize,
        tidy: &dyn Fn(&Rational) -> Rational,
    ) -> Option<(Vec<Rational>, Vec<Rational>, Rational)> {
        let product = |left: &[Rational], shape: &[Rational]| {
            matrix::dot(left, &matrix::applied(&self.mass, shape))
        };
        let without = |from: &[Rational], factor: Rational, other: &[Rational]| -> Vec<Rational> {
            from.iter().zip(other).map(|(entry, other)| tidy(&(entry - &factor * other))).collect()
        };
        let mut known: Vec<(Vec<Rational>, Vec<Rational>, Rational)> = Vec::new();
        for (mut shape, mut left) in shapes.into_iter().zip(lefts) {
            for (before, left_before, mass) in &known {
                shape = without(&shape, product(left_before, &shape) / mass, before);
                left = without(&left, product(&left, before) / mass, left_before);
            }
            let shape = matrix::first_is_one(&shape, tidy);
            let left = matrix::first_is_one(&left, tidy);
            let mass = product(&left, &shape);
            if mass.is_zero() {
                return None;
            }
            known.push((shape, left, mass));
        }
        (place < known.len()).then(|| known.swap_remove(place))
    }

    /// `K - lambda M`.
    pub(crate) fn matrix_at(&self, lambda: &Rational) -> Matrix {
        matrix::less(&self.stiffness, lambda, &self.mass)
    }
}

/// An entry of exact numbers, or of rounded ones, with more digits than are kept.
pub(crate) fn tidied(entry: &Rational, exact: bool) -> Rational {
    /// The digits that elimination may lose.
    const SPARE: usize = 20;
    match exact {
        true => entry.clone(),
        false => rounded_fraction(entry, DIGITS + SPARE),
    }
}

/// The coefficients of `det(K - lambda M)`, lowest power first, from its values at whole numbers by
/// divided differences.
fn characteristic_polynomial(mass: &Matrix, stiffness: &Matrix) -> Vec<Rational> {
    let count = mass.len();
    let place = |index: usize| Rational::from_integer(index.into());
    let mut differences: Vec<Rational> = (0..=count)
        .map(|index| matrix::determinant(&matrix::less(stiffness, &place(index), mass)))
        .collect();
    for step in 1..=count {
        for index in (step..=count).rev() {
            let difference = &differences[index] - &differences[index - 1];
            differences[index] = difference / place(step);
        }
    }
    // Horner's rule for Newton's form.
    let mut polynomial: Vec<Rational> = vec![Rational::zero(); count + 1];
    for index in (0..=count).rev() {
        for power in (0..=count).rev() {
            let lower = if power > 0 { polynomial[power - 1].clone() } else { Rational::zero() };
            polynomial[power] = lower - &polynomial[power] * place(index);
        }
        polynomial[0] += &differences[index];
    }
    polynomial
}

/// A simple root of a polynomial to [`DIGITS`] digits, by Newton's method in fractions.
fn refined(start: f64, polynomial: &[Rational]) -> Rational {
    /// Newton's method doubles the fifteen digits of the start each time.
    const STEPS: usize = 4;
    let slope = derivative(polynomial);
    let value = |polynomial: &[Rational], place: &Rational| {
        polynomial.iter().rev().fold(Rational::zero(), |sum, number| sum * place + number)
    };
    let mut root = from_f64(start).unwrap_or_else(Rational::zero);
    for _ in 0..STEPS {
        let slope = value(&slope, &root);
        if slope.is_zero() {
            break;
        }
        root = rounded_fraction(&(&root - value(polynomial, &root) / slope), DIGITS + 10);
    }
    rounded_fraction(&root, DIGITS)
}

/// The number of times that a factor divides a polynomial.
fn multiplicity(polynomial: &[Rational], factor: &[Rational]) -> usize {
    let mut slope = polynomial.to_vec();
    let mut times = 0;
    while !slope.is_empty() && remainder(&slope, factor).is_empty() {
        slope = derivative(&slope);
        times += 1;
    }
    times
}

/// Rows of two.
type Pair = [[Polynomial; 2]; 2];

impl TwoModes {
    fn new(
        mass: &[Vec<Polynomial>],
        stiffness: &[Vec<Polynomial>],
        taken: Vec<Symbol>,
    ) -> Result<Self, ModeError> {
        let pair = |rows: &[Vec<Polynomial>]| -> Pair {
            [0, 1].map(|row| [0, 1].map(|column| rows[row][column].clone()))
        };
        let (mass, stiffness) = (pair(mass), pair(stiffness));
        let mut names = ModeNames { taken, definitions: vec![] };
        let alone = has_row_of_its_own(&mass, &stiffness);
        let squares = squares(&mass, &stiffness)?;
        let mut modes = Vec::new();
        let mut explicit = Vec::new();
        let values = squares.each_ref().map(Lambda::number);
        let [first, second] = squares;
        let both = [names.frequency(first, 1)?, names.frequency(second, 2)?];
        for (index, lambda) in both.into_iter().enumerate() {
            let number = index + 1;
            let entries = |transposed: bool| {
                let place = |row: usize, column: usize| match transposed {
                    true => (column, row),
                    false => (row, column),
                };
                [0, 1].map(|row| {
                    [0, 1].map(|column| {
                        let (i, j) = place(row, column);
                        if alone && (i, j) == (index, index) {
                            // Its root is that of this entry, under whatever name.
                            return Polynomial::zero();
                        }
                        lambda.less(&stiffness[i][j], &mass[i][j])
                    })
                })
            };
            let shape = names.null_vector(&entries(false), &format!("r{number}"))?;
            let is_symmetric = mass[0][1] == mass[1][0] && stiffness[0][1] == stiffness[1][0];
            let left = match is_symmetric {
                true => shape.clone(),
                false => names.null_vector(&entries(true), &format!("l{number}"))?,
            };
            let mut modal = Polynomial::zero();
            for i in 0..2 {
                for j in 0..2 {
                    modal.accumulate(&left[i].product(&mass[i][j]).product(&shape[j]));
                }
            }
            let inverse_mass = names.inverse(&modal, &format!("mu{number}"));
            modes.push(LinearMode {
                square: lambda.square.clone(),
                shape,
                left,
                inverse_mass: inverse_mass.ok_or(ModeError::NotReal)?,
            });
            explicit.push(lambda.explicit);
        }
        let [Some(first), Some(second)] = [modes.pop(), modes.pop()] else {
            return Err(ModeError::NotReal);
        };
        let [last, before] = [explicit.pop().flatten(), explicit.pop().flatten()];
        Ok(Self {
            modes: [second, first],
            explicit: [before, last],
            values,
            definitions: names.definitions,
        })
    }

    fn mode(&self, index: usize) -> Result<LinearMode, ModeError> {
        let (number, mode) = (index + 1, &self.modes[index]);
        if let Some(value) = self.values[index].filter(|value| *value <= 0.0) {
            return Err(match value < 0.0 {
                true => ModeError::Unstable { number, square: significant(value, 6) },
                false => ModeError::NoStiffness { number },
            });
        }
        let [first, second] = &self.explicit;
        if let (Some(first), Some(second)) = (first, second)
            && first == second
        {
            let (other, square) = (2 - index, first.to_string());
            return Err(ModeError::EqualFrequencies { number, other, square });
        }
        Ok(mode.clone())
    }
}

/// Whether one coordinate does not feel the other, so that each diagonal entry has a root.
fn has_row_of_its_own(mass: &Pair, stiffness: &Pair) -> bool {
    let across = |row: usize| mass[row][1 - row].is_zero() && stiffness[row][1 - row].is_zero();
    across(0) || across(1)
}

/// The two roots lambda, each as a polynomial where it is one.
fn squares(mass: &Pair, stiffness: &Pair) -> Result<[Lambda; 2], ModeError> {
    let minus = |mut left: Polynomial, right: &Polynomial| {
        let mut right = right.clone();
        right.negate();
        left.accumulate(&right);
        left
    };
    if has_row_of_its_own(mass, stiffness) {
        return Ok(
            [0, 1].map(|index| Lambda::quotient(&stiffness[index][index], &mass[index][index]))
        );
    }
    let determinant = |of: &Pair| minus(of[0][0].product(&of[1][1]), &of[0][1].product(&of[1][0]));
    let leading = determinant(mass);
    if leading.is_zero() {
        return Err(ModeError::Massless);
    }
    let last = determinant(stiffness);
    let mut middle = stiffness[0][0].product(&mass[1][1]);
    middle.accumulate(&stiffness[1][1].product(&mass[0][0]));
    middle = minus(middle, &stiffness[0][1].product(&mass[1][0]));
    middle = minus(middle, &stiffness[1][0].product(&mass[0][1]));
    let mut four = leading.product(&last);
    four = four.product(&whole(4));
    let under_root = minus(middle.product(&middle), &four);
    let half = leading.product(&whole(2));
    if let Some(root) = under_root.single_term_root() {
        let lower = minus(middle.clone(), &root);
        let mut upper = middle;
        upper.accumulate(&root);
        return Ok([Lambda::quotient(&lower, &half), Lambda::quotient(&upper, &half)]);
    }
    let root = Expr::from(&under_root).sqrt().map_err(|_| ModeError::NotReal)?;
    let of = |sign: i64| -> Result<Lambda, ExprError> {
        let above = &Expr::from(&middle) + &(&root * &Expr::from(sign));
        let value = Expr::divide(&above, &Expr::from(&half))?.expand()?;
        Ok(Lambda { value, explicit: None })
    };
    Ok([of(-1)?, of(1)?])
}

/// A root lambda of two coordinates.
struct Lambda {
    value: Expr,
    explicit: Option<Polynomial>,
}

impl Lambda {
    fn quotient(above: &Polynomial, below: &Polynomial) -> Self {
        let explicit = below.power(-1).map(|inverse| above.product(&inverse));
        let value = match &explicit {
            Some(quotient) => Expr::from(quotient),
            None => Expr::divide(&Expr::from(above), &Expr::from(below))
                .unwrap_or_else(|_| Expr::zero()),
        };
        Self { value, explicit }
    }

    /// The root if no letters stand in it.
    fn number(&self) -> Option<f64> {
        self.value.evaluate(&Default::default()).ok()
    }
}

/// A root lambda with its name.
struct LambdaName {
    /// The root as a product of powers: a number, a letter, the square of a frequency.
    square: Polynomial,
    explicit: Option<Polynomial>,
}

impl LambdaName {
    /// `stiffness - lambda mass`.
    fn less(&self, stiffness: &Polynomial, mass: &Polynomial) -> Polynomial {
        let mut moved = self.explicit.as_ref().unwrap_or(&self.square).product(mass);
        moved.negate();
        moved.accumulate(stiffness);
        moved
    }
}

/// The names of the closed modes.
struct ModeNames {
    taken: Vec<Symbol>,
    definitions: Vec<Definition>,
}

impl ModeNames {
    fn define(&mut self, wanted: &str, meaning: Expr) -> Symbol {
        let symbol = fresh(wanted, &self.taken);
        self.taken.push(symbol);
        self.definitions.push(Definition { symbol, meaning });
        symbol
    }

    /// The name of a frequency, unless its square is a product of powers.
    fn frequency(&mut self, lambda: Lambda, number: usize) -> Result<LambdaName, ModeError> {
        let negative = lambda.number().is_some_and(|value| value < 0.0);
        let explicit = lambda.explicit;
        let is_product =
            |explicit: &&Polynomial| explicit.is_zero() || explicit.single_term().is_some();
        if let Some(product) = explicit.as_ref().filter(is_product) {
            return Ok(LambdaName { square: product.clone(), explicit });
        }
        if negative {
            let square = Polynomial::symbol(self.define(&format!("lambda{number}"), lambda.value));
            return Ok(LambdaName { square, explicit });
        }
        let frequency = lambda.value.sqrt()?;
        let name = Polynomial::symbol(self.define(&format!("omega{number}"), frequency));
        Ok(LambdaName { square: name.product(&name), explicit })
    }

    /// The inverse of a sum, which has a name unless it is a product of powers; `None` of zero.
    fn inverse(&mut self, sum: &Polynomial, wanted: &str) -> Option<Polynomial> {
        if sum.is_zero() {
            return None;
        }
        sum.power(-1).or_else(|| Polynomial::symbol(self.define(wanted, Expr::from(sum))).power(-1))
    }

    /// The vector that a matrix of rank one makes zero.
    fn null_vector(
        &mut self,
        rows: &[[Polynomial; 2]; 2],
        wanted: &str,
    ) -> Result<Vec<Polynomial>, ModeError> {
        let one = || Polynomial::constant(Rational::one());
        let row = rows.iter().find(|row| !row[0].is_zero() || !row[1].is_zero());
        let Some([own, other]) = row else {
            // Any vector is one of equal frequencies, which are refused mode by mode.
            return Ok(vec![one(), Polynomial::zero()]);
        };
        if own.is_zero() {
            return Ok(vec![one(), Polynomial::zero()]);
        }
        if other.is_zero() {
            return Ok(vec![Polynomial::zero(), one()]);
        }
        if let Some(inverse) = other.power(-1) {
            let mut ratio = own.product(&inverse);
            ratio.negate();
            if ratio.is_zero() || ratio.single_term().is_some() {
                return Ok(vec![one(), ratio]);
            }
        }
        let ratio = Expr::divide(&-&Expr::from(own), &Expr::from(other))?;
        Ok(vec![one(), Polynomial::symbol(self.define(wanted, ratio))])
    }
}

//! Formulas with constants: powers of quotients of sums of short functions.
//!
//! ```text
//! y ~ ((theta_0 + theta_1 b_1 + ...)/(1 + phi_1 d_1 + ...))^n
//! ```
//!
//! In: the truth, and short functions of the quantities it may depend on. Out: for each length the
//! structures with the smallest errors, their constants not yet short. One function is taken from all of
//! them, two and three from the shortest ones. A structure costs a fit of a few steps.

use num_traits::{One as _, Zero as _};

use super::formula::Formula;
use super::minimax::{Fit, FitSteps, MOST_CONSTANTS, PowerOfQuotient, QuotientOfSums};
use crate::exact::Rational;
use crate::exact::rational::{ratio, to_f64};
use crate::parallel::par_map;

/// A short function and its values at the places of a fit.
pub(super) struct ShortFunction {
    pub(super) formula: Formula,
    /// The length of its product with a constant of one digit, `7*u`, or `7/u` for `1/u`.
    pub(super) term_length: usize,
    pub(super) values: Vec<f64>,
    /// The power of the variable as which it grows towards infinity.
    pub(super) growth: f64,
    /// The first coefficients of its power series in the variable, where laws are exact at rest; empty
    /// where they need not be, or where it has no series of fractions.
    pub(super) series: Vec<Rational>,
}

/// A choice of functions.
#[derive(Clone, Debug)]
pub(super) struct Structure {
    /// n.
    pub(super) power: Rational,
    /// Whether the numerator has a constant.
    pub(super) has_constant: bool,
    /// The functions of the numerator and of the denominator, by number.
    pub(super) numerator: Vec<usize>,
    pub(super) denominator: Vec<usize>,
    /// The length with constants of one digit.
    pub(super) length: usize,
    pub(super) fit: Fit,
}

/// The powers to which a quotient is taken.
fn powers() -> Vec<Rational> {
    let all = [
        (1, 1),
        (2, 1),
        (1, 2),
        (-1, 1),
        (-2, 1),
        (-1, 2),
        (1, 4),
        (-1, 4),
        (4, 1),
        (3, 1),
        (-4, 1),
        (1, 3),
        (2, 3),
        (-1, 3),
        (3, 2),
        (-3, 2),
        (3, 4),
        (3, 8),
        (1, 6),
        (1, 8),
        (-1, 8),
    ];
    all.iter().map(|&(above, below)| ratio(above, below)).collect()
}

/// The number of the shortest functions from which one, two and three are chosen.
const CHOSEN_FROM: [usize; 3] = [400, 56, 20];

/// The largest number of structures of a length that are kept, and the ratio to the smallest error of
/// structures that are no longer up to which they are.
const KEPT: usize = 24;
const WORSE: f64 = 3.0;

/// Steps of the fit of a structure.
const STEPS: usize = 6;

/// The ratio to the error up to which structures are kept from which on the first steps decide: the others
/// gain less than that.
const GIVEN_UP: f64 = 5.0;

/// The truth as a power n of z, and the functions over z.
pub(super) struct RelativeFunctions {
    power: Rational,
    /// `1/z` at the places.
    one: Vec<f64>,
    functions: Vec<Vec<f64>>,
}

impl RelativeFunctions {
    /// The functions for all powers with which z has values.
    pub(super) fn of_all_powers(functions: &[ShortFunction], truth: &[f64]) -> Vec<Self> {
        let of_power = |power: Rational| {
            let exponent = -1.0 / to_f64(&power);
            let one: Vec<f64> = truth.iter().map(|value| value.powf(exponent)).collect();
            if !one.iter().all(|value| value.is_normal()) {
                return None;
            }
            let over = |function: &ShortFunction| {
                function.values.iter().zip(&one).map(|(value, one)| value * one).collect()
            };
            let functions = functions.iter().map(over).collect();
            Some(Self { power, one, functions })
        };
        powers().into_iter().filter_map(of_power).collect()
    }
}

impl Structure {
    /// The sums with values at the places of a fit; `None` if the power has none there.
    pub(super) fn sums<'a>(
        &self,
        functions: &'a [ShortFunction],
        relative: &'a [RelativeFunctions],
    ) -> Option<QuotientOfSums<'a>> {
        let relative = relative.iter().find(|own| own.power == self.power)?;
        let choice = (self.has_constant, &self.numerator[..], &self.denominator[..]);
        Some(sums(choice, functions, relative, PowerOfQuotient::new(&self.power)))
    }

    /// The constants with which the series of the law agrees with this series of z: an offset and a
    /// matrix by which they follow from those that are free; `None` if there are none.
    pub(super) fn tied(
        &self,
        functions: &[ShortFunction],
        target: &[Rational],
    ) -> Option<(Vec<Rational>, Vec<Vec<Rational>>)> {
        let orders = target.len();
        let mut columns: Vec<Vec<Rational>> = vec![];
        if self.has_constant {
            let mut one = vec![Rational::zero(); orders];
            one[0] = Rational::one();
            columns.push(one);
        }
        for &i in &self.numerator {
            columns.push(functions[i].series.get(..orders)?.to_vec());
        }
        for &i in &self.denominator {
            let own = functions[i].series.get(..orders)?;
            let product = |order: usize| -> Rational {
                (0..=order).map(|k| -(&own[k] * &target[order - k])).sum()
            };
            columns.push((0..orders).map(product).collect());
        }
        let count = columns.len();
        // Rows with the right side last, brought to reduced echelon form.
        let mut rows: Vec<Vec<Rational>> = (0..orders)
            .map(|order| {
                let own = columns.iter().map(|column| column[order].clone());
                own.chain([target[order].clone()]).collect()
            })
            .collect();
        let mut pivots: Vec<usize> = vec![];
        for column in 0..count {
            let done = pivots.len();
            let Some(pivot) = (done..orders).find(|&row| !rows[row][column].is_zero()) else {
                continue;
            };
            rows.swap(done, pivot);
            let scale = rows[done][column].recip();
            rows[done].iter_mut().for_each(|entry| *entry *= &scale);
            let own = rows[done].clone();
            for (_, row) in rows.iter_mut().enumerate().filter(|(row, _)| *row != done) {
                let factor = row[column].clone();
                row.iter_mut().zip(&own).for_each(|(entry, own)| *entry -= &factor * own);
            }
            pivots.push(column);
        }
        if rows[pivots.len()..].iter().any(|row| !row[count].is_zero()) {
            return None;
        }
        let free: Vec<usize> = (0..count).filter(|column| !pivots.contains(column)).collect();
        let mut offset = vec![Rational::zero(); count];
        let mut matrix = vec![vec![Rational::zero(); free.len()]; count];
        for (row, &column) in pivots.iter().enumerate() {
            offset[column] = rows[row][count].clone();
            for (k, &other) in free.iter().enumerate() {
                matrix[column][k] = -rows[row][other].clone();
            }
        }
        for (k, &column) in free.iter().enumerate() {
            matrix[column][k] = Rational::one();
        }
        Some((offset, matrix))
    }

    /// The formula with these constants and a factor of the whole.
    pub(super) fn formula(
        &self,
        functions: &[ShortFunction],
        constants: &[Rational],
        factor: Option<&Rational>,
    ) -> Formula {
        let own = usize::from(self.has_constant);
        let (above, below) = constants.split_at(own + self.numerator.len());
        let terms = |chosen: &[usize], constants: &[Rational]| -> Vec<Formula> {
            let pairs = chosen.iter().zip(constants);
            pairs.map(|(&i, constant)| functions[i].formula.clone().times(constant)).collect()
        };
        let constant = above[..own].iter().map(|number| Formula::Number(number.clone()));
        let numerator = sum(constant.chain(terms(&self.numerator, &above[own..])).collect());
        let whole = match self.denominator.is_empty() {
            true => numerator,
            false => {
                let rest = terms(&self.denominator, below);
                let below = sum(std::iter::once(Formula::integer(1)).chain(rest).collect());
                Formula::Quotient(numerator.into(), below.into())
            }
        };
        let whole = whole.power(&self.power);
        match factor {
            None => whole,
            Some(factor) => match whole {
                // 4/(1 + u)^2 for 4*(1/(1 + u)^2).
                Formula::Power(base, power) if power < ratio(0, 1) => Formula::Quotient(
                    Formula::Number(factor.clone()).into(),
                    base.power(&-power).into(),
                ),
                whole => whole.times(factor),
            },
        }
    }
}

/// A sum, its first term positive if one is.
fn sum(mut terms: Vec<Formula>) -> Formula {
    let is_negative = |term: &Formula| term.to_string().starts_with('-');
    if let Some(first) = terms.iter().position(|term| !is_negative(term)) {
        terms[..=first].rotate_right(1);
    }
    let mut terms = terms.into_iter();
    let first = terms.next().unwrap_or_else(|| Formula::integer(0));
    terms.fold(first, Formula::plus)
}

/// The quotient of sums of a choice of functions: whether it has a constant, and the numbers of the others.
fn sums<'a>(
    (has_constant, numerator, denominator): (bool, &[usize], &[usize]),
    functions: &'a [ShortFunction],
    relative: &'a RelativeFunctions,
    power: PowerOfQuotient,
) -> QuotientOfSums<'a> {
    let one = has_constant.then_some(relative.one.as_slice());
    let above = numerator.iter().map(|&i| relative.functions[i].as_slice());
    let below = denominator.iter().map(|&i| functions[i].values.as_slice());
    QuotientOfSums {
        numerator: one.into_iter().chain(above).collect(),
        denominator: below.collect(),
        power,
        tie: None,
    }
}

/// The structures with the smallest errors by length, for functions over truths; where a growth is given, of
/// those that grow as that power of the variable.
pub(super) fn structures(
    functions: &[ShortFunction],
    relative: &[RelativeFunctions],
    growth: Option<f64>,
    longest: usize,
) -> Vec<Structure> {
    let choices = choices(functions);
    let blocks: Vec<&[Choice]> = choices.chunks(512).collect();
    let mut found: Vec<Structure> = vec![];
    for relative in relative {
        let power = &relative.power;
        let quotient = PowerOfQuotient::new(power);
        let cost = Formula::integer(7).power(power).length() - 1;
        let known = LeastErrors::of(&found, longest);
        let fitted = par_map(&blocks, |block| {
            let mut least = known.clone();
            let fits = block.iter().filter_map(|choice| {
                if *power < ratio(0, 1) && !choice.denominator.is_empty() {
                    return None;
                }
                let length = cost + choice.length(functions);
                let grows = to_f64(power) * choice.growth(functions);
                if length > longest || growth.is_some_and(|asked| !is_same_growth(grows, asked)) {
                    return None;
                }
                let Choice { has_constant, numerator, denominator } = choice;
                let own = (*has_constant, &numerator[..], &denominator[..]);
                let sums = sums(own, functions, relative, quotient);
                let given_up = GIVEN_UP * WORSE * least.up_to(length);
                let steps = FitSteps { count: STEPS, given_up };
                let fit = sums.minimax(&[None; MOST_CONSTANTS], steps)?;
                least.insert(length, fit.error);
                Some(Structure {
                    power: power.clone(),
                    has_constant: *has_constant,
                    numerator: numerator.clone(),
                    denominator: denominator.clone(),
                    length,
                    fit,
                })
            });
            thinned(fits.collect())
        });
        found.extend(fitted.into_iter().flatten());
    }
    thinned(found)
}

/// The least error of structures up to each length.
#[derive(Clone)]
struct LeastErrors(Vec<f64>);

impl LeastErrors {
    fn of(found: &[Structure], longest: usize) -> Self {
        let mut least = Self(vec![f64::INFINITY; longest + 1]);
        found.iter().for_each(|structure| least.insert(structure.length, structure.fit.error));
        least
    }

    fn up_to(&self, length: usize) -> f64 {
        self.0[length]
    }

    fn insert(&mut self, length: usize, error: f64) {
        self.0[length..].iter_mut().for_each(|least| *least = error.min(*least));
    }
}

/// The best structures of each length.
fn thinned(mut found: Vec<Structure>) -> Vec<Structure> {
    found.sort_by(|one, other| {
        one.length.cmp(&other.length).then(one.fit.error.total_cmp(&other.fit.error))
    });
    let (mut least, mut length, mut kept) = (f64::INFINITY, 0, 0);
    found.retain(|structure| {
        if structure.length != length {
            (length, kept) = (structure.length, 0);
        }
        least = least.min(structure.fit.error);
        kept += 1;
        kept <= KEPT && structure.fit.error <= WORSE * least
    });
    found
}

/// A choice of functions for numerator and denominator.
struct Choice {
    has_constant: bool,
    numerator: Vec<usize>,
    denominator: Vec<usize>,
}

/// Whether two powers of growth, measured at large numbers, are the same.
pub(super) fn is_same_growth(one: f64, other: f64) -> bool {
    (one - other).abs() < 1e-2
}

impl Choice {
    /// The power of the variable as which the quotient grows towards infinity.
    fn growth(&self, functions: &[ShortFunction]) -> f64 {
        let largest = |chosen: &[usize], least: f64| {
            chosen.iter().map(|&i| functions[i].growth).fold(least, f64::max)
        };
        let own = if self.has_constant { 0.0 } else { f64::NEG_INFINITY };
        largest(&self.numerator, own) - largest(&self.denominator, 0.0)
    }

    /// The length with constants of one digit: `3 + 5*u` over `1 + 7*v`.
    fn length(&self, functions: &[ShortFunction]) -> usize {
        let terms = |chosen: &[usize]| -> usize {
            chosen.iter().map(|&i| functions[i].term_length).sum::<usize>()
        };
        let signs = |terms: usize| terms.saturating_sub(1);
        let own = usize::from(self.has_constant);
        let above = own + terms(&self.numerator) + signs(own + self.numerator.len());
        let below = match self.denominator.len() {
            0 => 0,
            count => 2 + terms(&self.denominator) + count,
        };
        above + below
    }
}

/// All choices of up to three functions.
fn choices(functions: &[ShortFunction]) -> Vec<Choice> {
    let mut all = vec![];
    let mut push = |has_constant: bool, chosen: &[usize], in_numerator: usize| {
        let (numerator, denominator) = chosen.split_at(in_numerator);
        all.push(Choice {
            has_constant,
            numerator: numerator.to_vec(),
            denominator: denominator.to_vec(),
        });
    };
    let [one, two, three] = CHOSEN_FROM.map(|count| count.min(functions.len()));
    for i in 0..one {
        push(true, &[i], 1);
        push(true, &[i], 0);
        push(false, &[i], 1);
    }
    for i in 0..two {
        for j in 0..two {
            push(true, &[i, j], 1);
            push(false, &[i, j], 1);
            if i < j {
                push(true, &[i, j], 2);
                push(true, &[i, j], 0);
                push(false, &[i, j], 2);
            }
        }
    }
    for i in 0..three {
        for j in i + 1..three {
            for k in 0..three {
                push(true, &[i, j, k], 2);
                push(true, &[k, i, j], 1);
                if k > j {
                    push(true, &[i, j, k], 3);
                }
            }
        }
    }
    all
}

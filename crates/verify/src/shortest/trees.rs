//! All short formulas of some quantities and whole numbers, each function once.
//!
//! In: the values of the quantities at some places. Out: formulas by length, made of those before by
//! `+ - * /`, square, square root and logarithm; of formulas with the same values at all places the
//! first one is kept. The number grows some fivefold with each symbol, and the time with it.

use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use super::Atom;
use super::formula::Formula;
use crate::exact::Rational;
use crate::parallel::par_map;

/// The whole numbers that are formulas by themselves.
const WHOLE_NUMBERS: [i64; 9] = [1, 2, 3, 4, 5, 6, 7, 8, 9];

/// Number of formulas after which no longer ones are kept.
const MOST: usize = 200_000;

/// The highest power of an atom.
const HIGHEST_POWER: i64 = 4;

/// The way in which a formula is made of others, given by their numbers.
#[derive(Clone, Copy, Debug)]
enum Made {
    Atom(usize),
    WholeNumber(i64),
    Power(usize, i64),
    Root(usize),
    Logarithm(usize),
    Joined(Sign, usize, usize),
}

#[derive(Clone, Copy, Debug)]
enum Sign {
    Plus,
    Minus,
    Times,
    Over,
}

const SIGNS: [Sign; 4] = [Sign::Plus, Sign::Minus, Sign::Times, Sign::Over];

impl Sign {
    fn of(self, left: f64, right: f64) -> f64 {
        match self {
            Self::Plus => left + right,
            Self::Minus => left - right,
            Self::Times => left * right,
            Self::Over => left / right,
        }
    }

    /// Whether the order of both sides matters.
    const fn is_ordered(self) -> bool {
        matches!(self, Self::Minus | Self::Over)
    }
}

/// One short formula.
#[derive(Clone, Debug)]
struct Tree {
    made: Made,
    length: usize,
    is_number: bool,
    values: Box<[f64]>,
}

/// Short formulas, by length.
pub(super) struct Trees<'a> {
    atoms: &'a [Atom],
    trees: Vec<Tree>,
    /// The number of formulas up to each length.
    ends: Vec<usize>,
    has_logarithms: bool,
}

impl<'a> Trees<'a> {
    /// All formulas up to a length of atoms with these values, with logarithms or without.
    pub(super) fn new(
        atoms: &'a [Atom],
        values: &[Vec<f64>],
        longest: usize,
        has_logarithms: bool,
    ) -> Self {
        let places = values.first().map_or(0, Vec::len);
        let mut found = Self { atoms, trees: vec![], ends: vec![0], has_logarithms };
        let mut known = HashSet::new();
        for length in 1..=longest {
            if found.trees.len() > MOST {
                break;
            }
            let mut kept: Vec<Tree> = vec![];
            let mut keep = |tree: Tree| {
                let is_new = tree.values.iter().all(|value| value.is_finite() && *value != 0.0)
                    && known.insert(fingerprint(&tree.values, |value| value));
                if is_new {
                    kept.push(tree);
                }
            };
            match length {
                1 => {
                    for (i, values) in values.iter().enumerate() {
                        let (made, values) = (Made::Atom(i), values.clone().into());
                        keep(Tree { made, length, is_number: false, values });
                    }
                    for number in WHOLE_NUMBERS {
                        let values = vec![number as f64; places].into();
                        keep(Tree {
                            made: Made::WholeNumber(number),
                            length,
                            is_number: true,
                            values,
                        });
                    }
                }
                _ => found.next(length, &mut keep),
            }
            found.trees.extend(kept);
            found.ends.push(found.trees.len());
        }
        found
    }

    /// Makes the formulas of a length, with those that are known already among them.
    fn next(&self, length: usize, keep: &mut dyn FnMut(Tree)) {
        let mut push = |made: Made, values: Box<[f64]>| {
            keep(Tree { made, length, is_number: false, values });
        };
        for i in self.of_length(length - 1) {
            let values = &self.trees[i].values;
            if !self.trees[i].is_number && values.iter().all(|value| *value > 0.0) {
                push(Made::Root(i), values.iter().map(|value| value.sqrt()).collect());
                if self.has_logarithms {
                    push(Made::Logarithm(i), values.iter().map(|value| value.ln()).collect());
                }
            }
        }
        for i in length.checked_sub(2).into_iter().flat_map(|length| self.of_length(length)) {
            let tree = &self.trees[i];
            // Higher powers than squares are those of an atom alone.
            let highest = match tree.made {
                Made::WholeNumber(_) => 1,
                Made::Atom(_) => HIGHEST_POWER,
                _ => 2,
            };
            for power in 2..=highest {
                let values = tree.values.iter().map(|value| value.powi(power as i32));
                push(Made::Power(i, power), values.collect());
            }
        }
        for (i, j, sign) in self.pairs(length) {
            let pairs = self.trees[i].values.iter().zip(&self.trees[j].values);
            push(Made::Joined(sign, i, j), pairs.map(|(a, b)| sign.of(*a, *b)).collect());
        }
    }

    fn of_length(&self, length: usize) -> std::ops::Range<usize> {
        match (self.ends.get(length.wrapping_sub(1)), self.ends.get(length)) {
            (Some(&from), Some(&to)) => from..to,
            _ => 0..0,
        }
    }

    /// The pairs of formulas that make one of this length.
    fn pairs(&self, length: usize) -> impl Iterator<Item = (usize, usize, Sign)> + '_ {
        (1..length.saturating_sub(1)).flat_map(move |left| {
            let right = length - 1 - left;
            self.of_length(left).flat_map(move |i| {
                self.of_length(right).flat_map(move |j| {
                    let is_of_numbers = self.trees[i].is_number && self.trees[j].is_number;
                    SIGNS.into_iter().filter_map(move |sign| {
                        let is_new = sign.is_ordered() || (left, i) <= (right, j);
                        (is_new && !is_of_numbers).then_some((i, j, sign))
                    })
                })
            })
        })
    }

    /// The formula of a tree.
    pub(super) fn formula(&self, tree: usize) -> Formula {
        self.made(self.trees[tree].made)
    }

    fn made(&self, made: Made) -> Formula {
        let part = |tree: usize| Box::new(self.formula(tree));
        match made {
            Made::Atom(i) => Formula::Name(self.atoms[i].name),
            Made::WholeNumber(number) => Formula::integer(number),
            Made::Power(tree, power) => {
                Formula::Power(part(tree), Rational::from_integer(power.into()))
            }
            Made::Root(tree) => Formula::Power(part(tree), Rational::new(1.into(), 2.into())),
            Made::Logarithm(tree) => Formula::Logarithm(part(tree)),
            Made::Joined(Sign::Plus, left, right) => Formula::Sum(part(left), part(right)),
            Made::Joined(Sign::Minus, left, right) => Formula::Difference(part(left), part(right)),
            Made::Joined(Sign::Times, left, right) => match self.trees[left].made {
                Made::WholeNumber(number) => {
                    self.formula(right).times(&Rational::from_integer(number.into()))
                }
                _ => Formula::Product(part(left), part(right)),
            },
            Made::Joined(Sign::Over, left, right) => Formula::Quotient(part(left), part(right)),
        }
    }

    /// The formulas, one for each function up to a factor and a constant that may be added, that are no
    /// longer than this: their numbers, the shortest first.
    pub(super) fn functions(&self, longest: usize) -> Vec<usize> {
        let mut known = HashSet::new();
        let end = self.ends.get(longest).copied().unwrap_or(self.trees.len());
        let own = self.trees[..end].iter().enumerate().filter(|(_, tree)| {
            let (first, last) = match (tree.values.first(), tree.values.last()) {
                (Some(first), Some(last)) if first != last => (*first, *last),
                _ => return false,
            };
            !tree.is_number
                && known.insert(fingerprint(&tree.values, |v| (v - first) / (last - first)))
        });
        own.map(|(i, _)| i).collect()
    }

    /// The formulas nearest to the truth by length, up to one that is longer than those that are kept.
    /// Formulas of the longer lengths are made of two that are kept, or are the square root of such.
    pub(super) fn nearest(&self, truth: &[f64], longest: usize) -> Vec<Formula> {
        /// Number of formulas of each length that are tried at more places.
        const KEPT: usize = 6;
        let squared: Vec<f64> = truth.iter().map(|value| value * value).collect();
        let mut found = vec![];
        for length in 1..=longest {
            let mut best: Vec<(f64, Made, bool)> = match self.ends.len() > length {
                true => {
                    let own = self.of_length(length).map(|i| {
                        let values = self.trees[i].values.iter().copied();
                        (distance(values, truth, f64::INFINITY), self.trees[i].made, false)
                    });
                    own.collect()
                }
                false => self.longer(length, truth, &squared, KEPT),
            };
            best.retain(|(error, ..)| error.is_finite());
            best.sort_by(|one, other| one.0.total_cmp(&other.0));
            best.truncate(KEPT);
            found.extend(best.into_iter().map(|(_, made, is_root)| {
                let formula = self.made(made);
                match is_root {
                    true => Formula::Power(formula.into(), Rational::new(1.into(), 2.into())),
                    false => formula,
                }
            }));
        }
        found
    }

    /// The nearest formulas of a length of which not all are kept, each with whether its root is meant.
    fn longer(
        &self,
        length: usize,
        truth: &[f64],
        squared: &[f64],
        kept: usize,
    ) -> Vec<(f64, Made, bool)> {
        let splits: Vec<(usize, usize, bool)> = [(length, false), (length - 1, true)]
            .into_iter()
            .flat_map(|(length, is_root)| {
                (1..length.saturating_sub(1)).map(move |left| (left, length - 1 - left, is_root))
            })
            .flat_map(|(left, right, is_root)| {
                self.of_length(left).map(move |i| (i, right, is_root))
            })
            .collect();
        let chunks: Vec<&[(usize, usize, bool)]> = splits.chunks(256).collect();
        let all = par_map(&chunks, |chunk| {
            let mut best: Vec<(f64, Made, bool)> = vec![];
            let mut limit = f64::INFINITY;
            for &(i, right, is_root) in *chunk {
                let truth = if is_root { squared } else { truth };
                for j in self.of_length(right) {
                    let (left, other) = (&self.trees[i], &self.trees[j]);
                    if left.is_number && other.is_number {
                        continue;
                    }
                    for sign in SIGNS {
                        if !sign.is_ordered() && (left.length, i) > (other.length, j) {
                            continue;
                        }
                        let pairs = left.values.iter().zip(&other.values);
                        let values = pairs.map(|(a, b)| sign.of(*a, *b));
                        let error = distance(values, truth, limit);
                        if error < limit {
                            best.push((error, Made::Joined(sign, i, j), is_root));
                            if best.len() >= 4 * kept {
                                best.sort_by(|one, other| one.0.total_cmp(&other.0));
                                best.truncate(kept);
                                limit = best.last().map_or(limit, |(error, ..)| *error);
                            }
                        }
                    }
                }
            }
            best
        });
        let squares =
            self.of_length(length.saturating_sub(2)).filter(|&i| !self.trees[i].is_number);
        let squares = squares.map(|i| {
            let values = self.trees[i].values.iter().map(|value| value * value);
            (distance(values, truth, f64::INFINITY), Made::Power(i, 2), false)
        });
        all.into_iter().flatten().chain(squares).collect()
    }
}

/// The largest relative distance of values from the truth; infinite as soon as it is beyond a limit.
fn distance(values: impl Iterator<Item = f64>, truth: &[f64], limit: f64) -> f64 {
    let mut largest = 0.0_f64;
    for (value, truth) in values.zip(truth) {
        let error = (value / truth - 1.0).abs();
        if error.is_nan() || error >= limit {
            return f64::INFINITY;
        }
        largest = largest.max(error);
    }
    largest
}

/// A number that is the same for values that agree to some seven digits.
fn fingerprint(values: &[f64], change: impl Fn(f64) -> f64) -> u64 {
    let mut hasher = DefaultHasher::new();
    for value in values {
        // Zero has one sign.
        ((change(*value) as f32) + 0.0).to_bits().hash(&mut hasher);
    }
    hasher.finish()
}

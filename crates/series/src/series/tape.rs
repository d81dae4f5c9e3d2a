//! Taylor coefficients of many quantities at once: a list of recurrences, computed order by order.
//!
//! In: operations in an order in which they can be computed, and the coefficients of the variables.
//! Out: those of everything else, one order beyond what the variables have so far. With
//! `u = u_0 + u_1 s + ...`:
//!
//! ```text
//! (u v)_n = sum_k u_k v_(n-k)            p = u^a:   n u_0 p_n = sum_(k=1..n) (a k - n + k) u_k p_(n-k)
//! q = u/v:  v_0 q_n = u_n - sum_(k=1..n) v_k q_(n-k)
//! y' = u' g:   n y_n = sum_(k=1..n) k u_k g_(n-k)          exp: g = y;  tan: g = 1 + y^2;  sin: g = cos
//! y' = u'/v:   n v_0 y_n = n u_n - sum_(0<k<n) k y_k v_(n-k)      log: v = u;  atan: v = 1 + u^2
//! ```
//!
//! An order costs one product sum for each product, quotient and integral: `n` multiplications, or
//! fewer where an operand is a number or grows like time.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::symbol::Symbol;

/// What a place holds; operands are places of series.
#[derive(Clone, Debug)]
pub(super) enum Operation {
    /// A variable or a number: nothing to compute.
    Given,
    /// Some series, each times a number: the places of both.
    Sum(Box<[(usize, usize)]>),
    /// The first is zero beyond this order.
    Multiply(usize, usize, usize),
    /// The second is zero beyond this order.
    Divide(usize, usize, usize),
    /// `s u'`: the coefficients `n u_n`.
    Slope(usize),
    /// A power that is no whole number, of what is not zero; its value, which is negative where the
    /// base may be.
    Power { base: usize, exponent: f64, first: fn(f64, f64) -> f64 },
    /// `y' = u' g`, with a function of the value of `u` to begin with: the place of `u`, that of
    /// its slope, which is zero beyond an order, and that of `g`.
    Integral { of: usize, slope: usize, degree: usize, rate: usize, first: fn(f64) -> f64 },
    /// `y' = u'/v`, times a sign: the place of `u`, those of the slopes of `u` and of `y` itself,
    /// and that of `v`.
    Quotient { of: usize, slope: usize, own: usize, over: usize, sign: f64, first: fn(f64) -> f64 },
    /// Sine and cosine, or their hyperbolic sisters, in this place and the next: `y' = u' z`,
    /// `z' = sign u' y`.
    Waves { of: usize, slope: usize, degree: usize, sign: f64, first: [fn(f64) -> f64; 2] },
    /// The second of the waves in the place before.
    SecondWave,
    /// One of two series, by the side of a corner; zero where there is none.
    Choose { corner: usize, positive: Option<usize>, negative: Option<usize> },
}

impl Operation {
    /// The places that what is at this one reads.
    fn operands(&self, place: usize) -> Vec<usize> {
        match self {
            Self::Given => vec![],
            Self::Sum(terms) => {
                terms.iter().flat_map(|(weight, place)| [*weight, *place]).collect()
            }
            Self::Multiply(a, b, _) | Self::Divide(a, b, _) => vec![*a, *b],
            Self::Slope(a) => vec![*a],
            Self::Power { base, .. } => vec![*base],
            Self::Integral { of, slope, rate, .. } => vec![*of, *slope, *rate],
            Self::Quotient { of, slope, own, over, .. } => vec![*of, *slope, *own, *over],
            Self::Waves { of, slope, .. } => vec![*of, *slope],
            Self::SecondWave => place.checked_sub(1).into_iter().collect(),
            Self::Choose { positive, negative, .. } => {
                positive.iter().chain(negative).copied().collect()
            }
        }
    }
}

/// Where an expression has another formula on either side: the sign of a series, and the side that
/// is taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) argument: usize,
    pub(super) side: f64,
}

/// Operations and the series of all of them.
#[derive(Clone, Debug)]
pub struct Tape {
    /// Coefficients in a series.
    length: usize,
    operations: Vec<Operation>,
    /// The order from which a series is zero, where there is one.
    degrees: Vec<Option<usize>>,
    /// Places of what changes with the order, and of what is only a number.
    changing: Vec<usize>,
    numbers: Vec<usize>,
    /// The coefficients of each place.
    series: Vec<Box<[f64]>>,
    /// The place of the slope of each variable that is fed.
    slopes: Vec<Option<usize>>,
    /// `1/n`.
    inverse: Vec<f64>,
    pub(super) corners: Vec<Corner>,
    /// The letters with a number, each with its place.
    pub(super) named: Vec<(Symbol, usize)>,
}

impl Tape {
    /// Nothing yet; series are to have the orders up to this one.
    pub(super) fn new(degree: usize) -> Self {
        Self {
            length: degree + 1,
            operations: vec![],
            degrees: vec![],
            changing: vec![],
            numbers: vec![],
            series: vec![],
            slopes: vec![],
            inverse: (0..degree + 2).map(|n| 1.0 / n as f64).collect(),
            corners: vec![],
            named: vec![],
        }
    }

    /// Adds a variable or a number that is zero beyond this order, if it is.
    pub(super) fn given(&mut self, degree: Option<usize>) -> usize {
        self.push(Operation::Given, degree)
    }

    /// Adds an operation; answers its place.
    pub(super) fn emit(&mut self, operation: Operation) -> usize {
        let degree = |place: usize| self.degrees.get(place).copied().flatten();
        let constant = |place: usize| degree(place).filter(|degree| *degree == 0);
        let degree = match &operation {
            Operation::Given | Operation::SecondWave | Operation::Choose { .. } => None,
            Operation::Integral { .. } | Operation::Quotient { .. } | Operation::Waves { .. } => {
                None
            }
            Operation::Sum(terms) => terms
                .iter()
                .map(|term| degree(term.1))
                .try_fold(0, |most, degree| Some(most.max(degree?))),
            Operation::Multiply(a, b, _) => degree(*a).zip(degree(*b)).map(|(a, b)| a + b),
            Operation::Slope(a) => degree(*a),
            Operation::Divide(a, b, _) => constant(*a).and(constant(*b)),
            Operation::Power { base, .. } => constant(*base),
        };
        let place = self.push(operation, degree);
        match (degree, &self.operations[place]) {
            (_, Operation::SecondWave) => {}
            // The slope of a variable comes with its rate.
            (None, Operation::Slope(of)) if matches!(self.operations[*of], Operation::Given) => {
                self.slopes[*of] = Some(place);
            }
            (Some(0), _) => self.numbers.push(place),
            _ => self.changing.push(place),
        }
        place
    }

    fn push(&mut self, operation: Operation, degree: Option<usize>) -> usize {
        self.operations.push(operation);
        self.degrees.push(degree);
        self.series.push(vec![0.0; self.length].into());
        self.slopes.push(None);
        self.operations.len() - 1
    }

    /// The number of operations, which is the place of the next.
    pub(super) fn size(&self) -> usize {
        self.operations.len()
    }

    /// What is at a place.
    pub(super) fn operation(&self, place: usize) -> &Operation {
        &self.operations[place]
    }

    /// The order beyond which a series is zero.
    pub(super) fn degree(&self, place: usize) -> usize {
        self.degrees[place].unwrap_or(usize::MAX)
    }

    /// Whether a place holds a number, the same at every order.
    pub(super) fn is_number(&self, place: usize) -> bool {
        self.degrees[place] == Some(0)
    }

    /// Whether a place holds the number one, given as such.
    pub(super) fn is_one(&self, place: usize) -> bool {
        let given = matches!(self.operations[place], Operation::Given);
        given && self.is_number(place) && self.series(place)[0] == 1.0
    }

    /// Leaves out what is needed neither for these places nor for a corner.
    pub(super) fn keep_only(&mut self, outputs: &[usize]) {
        let mut needed = vec![false; self.operations.len()];
        let corners = self.corners.iter().map(|corner| corner.argument);
        let mut open: Vec<usize> = outputs.iter().copied().chain(corners).collect();
        while let Some(place) = open.pop() {
            if !std::mem::replace(&mut needed[place], true) {
                open.extend(self.operations[place].operands(place));
            }
        }
        self.changing.retain(|place| needed[*place]);
        self.numbers.retain(|place| needed[*place]);
    }

    /// Sets a coefficient of a variable.
    pub fn set(&mut self, place: usize, order: usize, value: f64) {
        self.series[place][order] = value;
    }

    /// Sets the numbers of letters anew; `false` where the operations may be others for these
    /// numbers, and where one is missing. With corners the numbers say which of them are one.
    #[must_use]
    pub fn set_numbers(&mut self, numbers: &BTreeMap<Symbol, f64>) -> bool {
        for index in 0..self.named.len() {
            let (name, place) = self.named[index];
            let before = self.series(place)[0];
            match numbers.get(&name) {
                Some(number) if number.to_bits() == before.to_bits() => {}
                // A factor of one may be left out.
                Some(number) if self.corners.is_empty() && *number != 1.0 && before != 1.0 => {
                    self.set(place, 0, *number)
                }
                _ => return false,
            }
        }
        true
    }

    /// The series at a place; what has no value is not a finite number.
    pub fn series(&self, place: usize) -> &[f64] {
        &self.series[place]
    }

    /// Computes the coefficients of this order of everything, where those of the variables and all
    /// lower ones are known.
    pub fn compute(&mut self, order: usize) {
        let numbers: &[usize] = if order == 0 { &self.numbers } else { &[] };
        let inverse = self.inverse[order];
        for &place in numbers.iter().chain(&self.changing) {
            let operation = &self.operations[place];
            compute_at(operation, place, &mut self.series, &self.corners, (order, inverse));
        }
    }

    /// `(n + 1) y_(n+1) = unit F_n`: hands a rate back to its variable, in this unit of time.
    pub fn feed(&mut self, variable: usize, rate: usize, order: usize, unit: f64) {
        let inverse = self.inverse[order + 1];
        let rate = self.series[rate][order];
        let slope = unit * rate;
        self.series[variable][order + 1] = inverse * slope;
        if let Some(place) = self.slopes[variable] {
            self.series[place][order + 1] = slope;
        }
    }
}

/// Computes the coefficient of order `n` of what is at a place; `inverse` is `1/n`.
fn compute_at(
    operation: &Operation,
    place: usize,
    series: &mut [Box<[f64]>],
    corners: &[Corner],
    (n, inverse): (usize, f64),
) {
    let row = |place: usize| &*series[place];
    let at = |place: usize, order: usize| series[place][order];
    let coefficient = match operation {
        Operation::Given | Operation::SecondWave => return,
        Operation::Sum(terms) => {
            let mut sum = 0.0;
            for (weight, place) in terms {
                sum += at(*weight, 0) * at(*place, n);
            }
            sum
        }
        Operation::Multiply(a, b, degree) => products(row(*a), row(*b), 0..n.min(*degree) + 1, n),
        Operation::Divide(a, b, degree) => {
            let known = products(row(*b), row(place), 1..n.min(*degree) + 1, n);
            (at(*a, n) - known) / at(*b, 0)
        }
        Operation::Slope(a) => n as f64 * at(*a, n),
        Operation::Power { base, exponent, first } if n == 0 => first(at(*base, 0), *exponent),
        // What is zero altogether, as behind a closed corner, has zero for its roots.
        Operation::Power { base, exponent, .. }
            if *exponent > 0.0 && row(*base)[..=n].iter().all(|c| *c == 0.0) =>
        {
            0.0
        }
        Operation::Power { base, exponent, .. } => {
            let weight = |k: usize| exponent * k as f64 - (n - k) as f64;
            let sum: f64 = (1..=n).map(|k| weight(k) * at(*base, k) * at(place, n - k)).sum();
            sum / (n as f64 * at(*base, 0))
        }
        Operation::Integral { of, first, .. } | Operation::Quotient { of, first, .. } if n == 0 => {
            first(at(*of, 0))
        }
        Operation::Integral { slope, degree, rate, .. } => {
            inverse * products(row(*slope), row(*rate), 1..n.min(*degree) + 1, n)
        }
        Operation::Quotient { slope, own, over, sign, .. } => {
            let known = products(row(*own), row(*over), 1..n, n);
            (sign * at(*slope, n) - known) * inverse / at(*over, 0)
        }
        Operation::Waves { of, slope, degree, sign, first } => {
            let [one, other] = match n {
                0 => first.map(|first| first(at(*of, 0))),
                _ => {
                    let orders = 1..n.min(*degree) + 1;
                    let sums = products_with(row(*slope), [row(place + 1), row(place)], orders, n);
                    [inverse * sums[0], sign * inverse * sums[1]]
                }
            };
            series[place + 1][n] = other;
            one
        }
        Operation::Choose { corner, positive, negative } => {
            let Corner { argument, side } = &corners[*corner];
            let chosen = if *side > 0.0 { positive } else { negative };
            match at(*argument, 0).is_finite() {
                true => chosen.map_or(0.0, |chosen| at(chosen, n)),
                // Without a value it has no side.
                false => f64::NAN,
            }
        }
    };
    series[place][n] = coefficient;
}

impl Tape {
    /// The series whose signs choose between formulas (`abs`, `sgn`, `H`, `max`, `min`), and on
    /// which side of zero they are taken to be.
    pub fn corners(&self) -> impl Iterator<Item = (&[f64], f64)> {
        let argument = |corner: &Corner| (self.series(corner.argument), corner.side);
        self.corners.iter().map(argument)
    }

    /// Takes the other side of a corner, by its number in [`corners`](Self::corners).
    pub fn cross(&mut self, corner: usize) {
        self.corners[corner].side *= -1.0;
    }

    /// Takes the side of every corner on which its series lies, or to which it is going; whether
    /// one of them is another now.
    pub fn take_sides(&mut self) -> bool {
        let mut changed = false;
        for index in 0..self.corners.len() {
            let Corner { argument, side } = self.corners[index];
            let first =
                self.series(argument).iter().find(|value| value.is_finite() && **value != 0.0);
            if let Some(first) = first.filter(|first| first.signum() != side) {
                self.corners[index].side = first.signum();
                changed = true;
            }
        }
        changed
    }
}

/// `sum_k a_k b_(n-k)` over these orders. Two sums, of even and of odd k: half the waiting of one
/// on the other.
fn products(a: &[f64], b: &[f64], orders: Range<usize>, n: usize) -> f64 {
    if orders.is_empty() {
        return 0.0;
    }
    let (a, b) = (&a[orders.clone()], &b[n + 1 - orders.end..=n - orders.start]);
    let (mut even, mut odd) = (0.0, 0.0);
    let (pairs, backwards) = (a.chunks_exact(2), b.rchunks_exact(2));
    let last = pairs.remainder().iter().zip(backwards.remainder());
    for (a, b) in pairs.zip(backwards) {
        even += a[0] * b[1];
        odd += a[1] * b[0];
    }
    for (a, b) in last {
        even += a * b;
    }
    even + odd
}

/// As [`products`], of one series with two others.
fn products_with(a: &[f64], [b, c]: [&[f64]; 2], orders: Range<usize>, n: usize) -> [f64; 2] {
    if orders.is_empty() {
        return [0.0; 2];
    }
    let a = &a[orders.clone()];
    let [b, c] = [b, c].map(|other| &other[n + 1 - orders.end..=n - orders.start]);
    let (mut even, mut odd) = ([0.0; 2], [0.0; 2]);
    let (pairs, [of_b, of_c]) = (a.chunks_exact(2), [b, c].map(|other| other.rchunks_exact(2)));
    let last = pairs.remainder().iter().zip(of_b.remainder().iter().zip(of_c.remainder()));
    for (a, (b, c)) in pairs.zip(of_b.zip(of_c)) {
        even[0] += a[0] * b[1];
        odd[0] += a[1] * b[0];
        even[1] += a[0] * c[1];
        odd[1] += a[1] * c[0];
    }
    for (a, (b, c)) in last {
        even[0] += a * b;
        even[1] += a * c;
    }
    [even[0] + odd[0], even[1] + odd[1]]
}

//! Taylor coefficients of many quantities at once: a list of recurrences, computed order by order,
//! for one motion or for several side by side.
//!
//! In: operations in an order in which they can be computed, and the values of the variables. Out:
//! the coefficients of all series. With `u = u_0 + u_1 s + ...`:
//!
//! ```text
//! (u v)_n = sum_k u_k v_(n-k)            p = u^a:   n u_0 p_n = sum_(k=1..n) (a k - n + k) u_k p_(n-k)
//! q = u/v:  v_0 q_n = u_n - sum_(k=1..n) v_k q_(n-k)
//! y' = u' g:   n y_n = sum_(k=1..n) k u_k g_(n-k)          exp: g = y;  tan: g = 1 + y^2;  sin: g = cos
//! y' = u'/v:   n v_0 y_n = n u_n - sum_(0<k<n) k y_k v_(n-k)      log: v = u;  atan: v = 1 + u^2
//! y' = F:      (n + 1) y_(n+1) = F_n
//! ```
//!
//! An order costs one sum of products for each product, quotient and integral: `n` multiplications,
//! or fewer if an operand is a number or a polynomial such as time.
//!
//! `L` motions go through the same operations side by side, each with its own numbers. The lanes
//! are independent, and no operation is fused or reordered: the result of each is bit for bit the
//! same as alone.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use aligned_vec::{AVec, ConstAlign};
use pulp::{Arch, Simd, WithSimd};

use crate::symbol::Symbol;

/// One instruction. Its operands, and its result, are series, each given by its index in the tape.
#[derive(Clone, Debug)]
pub(super) enum Operation {
    /// A variable or a number, for which nothing is computed.
    Given,
    /// A sum of series, each times a number: the places of number and series.
    Sum(Box<[(usize, usize)]>),
    /// A product; the first factor is zero beyond this order.
    Multiply(usize, usize, usize),
    /// A quotient; the divisor is zero beyond this order.
    Divide(usize, usize, usize),
    /// `s u'`: the coefficients `n u_n`.
    Slope(usize),
    /// A power with an exponent that is not whole, of a base that is not zero; `first` computes its
    /// value, also for a negative base if the root is odd.
    Power { base: usize, exponent: f64, first: fn(f64, f64) -> f64 },
    /// `y' = u' g`, where `first` gives the value of `y` from that of `u`: the places of `u`, of
    /// its slope, which is zero beyond the order `degree`, and of `g`.
    Integral { of: usize, slope: usize, degree: usize, rate: usize, first: fn(f64) -> f64 },
    /// `y' = u'/v`, times a sign: the places of `u`, of the slopes of `u` and of `y` itself, and of
    /// `v`.
    Quotient { of: usize, slope: usize, own: usize, over: usize, sign: f64, first: fn(f64) -> f64 },
    /// Sine and cosine, or the hyperbolic pair, in this place and the next: `y' = u' z`,
    /// `z' = sign u' y`.
    Waves { of: usize, slope: usize, degree: usize, sign: f64, first: [fn(f64) -> f64; 2] },
    /// The second series of the [`Operation::Waves`] in the place before.
    SecondWave,
    /// One of two series, by the side of a corner; zero if that series is `None`.
    Choose { corner: usize, positive: Option<usize>, negative: Option<usize> },
}

impl Operation {
    /// Returns the places that the operation at `place` reads.
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

/// The instructions of a system of expressions, in an order in which they can be computed, and the
/// numbers with which they begin.
#[derive(Clone, Debug)]
pub(super) struct Program {
    /// Number of coefficients in a series.
    length: usize,
    operations: Vec<Operation>,
    /// The order beyond which each series is zero; `None` if there is no such order.
    degrees: Vec<Option<usize>>,
    /// The value of each number; 0 for all other operations.
    values: Vec<f64>,
    /// Places of the series with higher orders, and of those that are only a number.
    changing: Vec<usize>,
    numbers: Vec<usize>,
    /// The series with higher orders that do not vanish beyond any order, and the order beyond
    /// which all others do.
    endless: Vec<usize>,
    longest: usize,
    /// The place of the slope of each variable, if it is needed.
    slopes: Vec<Option<usize>>,
    /// The places of the arguments whose signs choose between formulas.
    pub(super) corners: Vec<usize>,
    /// The symbols that have a number, each with its place.
    pub(super) named: Vec<(Symbol, usize)>,
}

impl Program {
    /// An empty program for series up to this order.
    pub(super) fn new(degree: usize) -> Self {
        Self {
            length: degree + 1,
            operations: vec![],
            degrees: vec![],
            values: vec![],
            changing: vec![],
            numbers: vec![],
            endless: vec![],
            longest: 0,
            slopes: vec![],
            corners: vec![],
            named: vec![],
        }
    }

    /// Adds a variable and returns its place; `degree` is the order beyond which it is zero, if
    /// any.
    pub(super) fn variable(&mut self, degree: Option<usize>) -> usize {
        self.push(Operation::Given, degree)
    }

    /// Adds a number and returns its place.
    pub(super) fn number(&mut self, value: f64) -> usize {
        let place = self.push(Operation::Given, Some(0));
        self.values[place] = value;
        place
    }

    /// Adds an operation and returns its place.
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
            // The slope of a variable is computed with its rate.
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
        self.values.push(0.0);
        self.slopes.push(None);
        self.operations.len() - 1
    }

    /// The number of operations, which is the place of the next.
    pub(super) fn size(&self) -> usize {
        self.operations.len()
    }

    /// The operation at an index.
    pub(super) fn operation(&self, place: usize) -> &Operation {
        &self.operations[place]
    }

    /// Returns the order beyond which a series is zero; the largest `usize` if there is none.
    pub(super) fn degree(&self, place: usize) -> usize {
        self.degrees[place].unwrap_or(usize::MAX)
    }

    /// Whether a place holds a number: a series without higher orders.
    pub(super) fn is_number(&self, place: usize) -> bool {
        self.degrees[place] == Some(0)
    }

    /// Whether a place holds the number one itself, not a computed one.
    pub(super) fn is_one(&self, place: usize) -> bool {
        let given = matches!(self.operations[place], Operation::Given);
        given && self.is_number(place) && self.values[place] == 1.0
    }

    /// Removes the operations that are needed neither for these places nor for a corner.
    pub(super) fn keep_only(&mut self, outputs: &[usize]) {
        let mut needed = vec![false; self.operations.len()];
        let mut open: Vec<usize> = outputs.iter().chain(&self.corners).copied().collect();
        while let Some(place) = open.pop() {
            if !std::mem::replace(&mut needed[place], true) {
                open.extend(self.operations[place].operands(place));
            }
        }
        self.changing.retain(|place| needed[*place]);
        self.numbers.retain(|place| needed[*place]);
        let ends = |place: &usize| self.degrees[*place].is_some();
        let changing = self.changing.iter().copied();
        let (polynomials, endless): (Vec<usize>, Vec<usize>) = changing.partition(ends);
        let degrees = polynomials.into_iter().filter_map(|place| self.degrees[place]);
        self.longest = degrees.max().unwrap_or(0);
        self.endless = endless;
    }
}

/// Bytes of a line of the processor's cache: eight motions side by side have one for each coefficient, and
/// none is read from two.
const CACHE_LINE: usize = 64;

/// The series of a system of expressions along `L` motions.
#[derive(Clone, Debug)]
pub struct Tape<const L: usize = 1> {
    program: Arc<Program>,
    /// The coefficients, place by place.
    series: AVec<[f64; L], ConstAlign<CACHE_LINE>>,
    /// The sign of each corner's argument that the formulas assume.
    sides: Vec<[f64; L]>,
}

impl Tape {
    /// A tape for a program, on which the variables are zero.
    pub(super) fn new(program: Program) -> Self {
        let mut series = AVec::from_iter(
            CACHE_LINE,
            std::iter::repeat_n([0.0], program.length * program.size()),
        );
        for (coefficients, value) in series.chunks_mut(program.length).zip(&program.values) {
            coefficients[0] = [*value];
        }
        Self { series, sides: vec![[1.0]; program.corners.len()], program: program.into() }
    }

    /// Sets a coefficient of a variable.
    #[inline]
    pub fn set(&mut self, place: usize, order: usize, value: f64) {
        self.series[place * self.program.length + order] = [value];
    }

    /// Sets new numbers for the symbols. Returns `false` if the operations may differ for these
    /// numbers, or if one is missing. The numbers in the arguments of corners, which determine the
    /// arguments that share a guard, must be the same.
    #[must_use]
    pub fn set_numbers(&mut self, numbers: &BTreeMap<Symbol, f64>) -> bool {
        for index in 0..self.program.named.len() {
            let (name, place) = self.program.named[index];
            let before = self.series(place)[0];
            match numbers.get(&name) {
                Some(number) if number.to_bits() == before.to_bits() => {}
                // The operations for a factor of one may differ, since it is left out.
                Some(number) if *number != 1.0 && before != 1.0 => self.set(place, 0, *number),
                _ => return false,
            }
        }
        true
    }

    /// The series at a place; coefficients without a value are not finite.
    #[inline]
    pub fn series(&self, place: usize) -> &[f64] {
        self.lanes(place).as_flattened()
    }

    /// Writes the values of the first variables at `s`, by Horner's rule for all of them side by
    /// side, so that no sum waits for another. They are bit for bit those of [`sums`](Self::sums).
    pub fn values(&self, s: f64, into: &mut [f64]) {
        let length = self.program.length;
        into.fill(0.0);
        for order in (0..length).rev() {
            for (place, value) in into.iter_mut().enumerate() {
                *value = *value * s + self.series[place * length + order][0];
            }
        }
    }

    /// Returns the series whose signs choose between formulas (`abs`, `sgn`, `H`, `max`, `min`),
    /// each with the sign that is assumed.
    #[inline]
    pub fn corners(&self) -> impl Iterator<Item = (&[f64], f64)> {
        let arguments = self.program.corners.iter().map(|argument| self.series(*argument));
        arguments.zip(self.sides.iter().map(|[side]| *side))
    }

    /// Takes the other side of a corner, given by its index in [`corners`](Self::corners).
    pub fn cross(&mut self, corner: usize) {
        self.sides[corner][0] *= -1.0;
    }

    /// Takes the positive side of every corner, as a new tape does.
    pub fn reset_sides(&mut self) {
        self.sides.fill([1.0]);
    }

    /// Takes the side of every corner on which its series lies, or to which it moves from zero.
    /// Returns whether a side has changed.
    pub fn take_sides(&mut self) -> bool {
        let mut changed = false;
        for (corner, argument) in self.program.corners.iter().enumerate() {
            let series = self.lanes(*argument).as_flattened();
            let first = series.iter().find(|value| value.is_finite() && **value != 0.0);
            if let Some(first) = first.filter(|first| first.signum() != self.sides[corner][0]) {
                self.sides[corner] = [first.signum()];
                changed = true;
            }
        }
        changed
    }

    /// Returns a tape of the same operations for several motions, all of which start as this one.
    pub fn side_by_side<const L: usize>(&self) -> Tape<L> {
        Tape {
            program: self.program.clone(),
            series: AVec::from_iter(CACHE_LINE, self.series.iter().map(|[value]| [*value; L])),
            sides: self.sides.iter().map(|[side]| [*side; L]).collect(),
        }
    }

    /// Whether another tape has the same operations, so that both may be computed side by side.
    #[inline]
    pub fn is_like(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.program, &other.program)
    }
}

impl<const L: usize> Tape<L> {
    /// Loads the variables, numbers and sides of one lane from a tape of its own with the same
    /// operations.
    pub fn load(&mut self, lane: usize, own: &Tape) {
        let length = self.program.length;
        let given = self.program.operations.iter().zip(self.series.chunks_mut(length));
        for ((operation, series), own) in given.zip(own.series.chunks(length)) {
            if matches!(operation, Operation::Given) {
                for (coefficients, [own]) in series.iter_mut().zip(own).take(2) {
                    coefficients[lane] = *own;
                }
            }
        }
        self.load_sides(lane, own);
    }

    /// Loads the first variables and the sides of one lane, which has all its numbers already, from
    /// a tape of its own with the same operations.
    pub fn load_point(&mut self, lane: usize, variables: usize, own: &Tape) {
        let length = self.program.length;
        let given = self.series.chunks_mut(length).zip(own.series.chunks(length));
        for (series, own) in given.take(variables) {
            for (coefficients, [own]) in series.iter_mut().zip(own).take(2) {
                coefficients[lane] = *own;
            }
        }
        self.load_sides(lane, own);
    }

    fn load_sides(&mut self, lane: usize, own: &Tape) {
        for (sides, [own]) in self.sides.iter_mut().zip(&own.sides) {
            sides[lane] = *own;
        }
    }

    /// Copies the series of one lane at these indices, and those of the corners, to a tape of its
    /// own with the same operations.
    pub fn copy_lane_to(&self, lane: usize, places: impl Iterator<Item = usize>, own: &mut Tape) {
        let length = self.program.length;
        for place in places.chain(self.program.corners.iter().copied()) {
            let own = &mut own.series[place * length..][..length];
            for (own, coefficients) in own.iter_mut().zip(self.lanes(place)) {
                *own = [coefficients[lane]];
            }
        }
    }

    /// The series at a place, lane by lane; coefficients without a value are not finite.
    #[inline]
    pub fn lanes(&self, place: usize) -> &[[f64; L]] {
        let length = self.program.length;
        &self.series[place * length..][..length]
    }

    /// Sums the series of the first variables, each lane at its own `s`, which is not negative.
    pub fn sums(&self, s: &[f64; L], into: &mut [SeriesSums<L>]) {
        Arch::new().dispatch(TapeSums { tape: self, s, into });
    }

    /// The places of the arguments of the corners.
    #[inline]
    pub fn corner_places(&self) -> &[usize] {
        &self.program.corners
    }

    /// Computes the coefficients of all series from the values of the variables; `rates` are the
    /// places of the rates of the first variables.
    pub fn expand(&mut self, rates: &[usize]) {
        Arch::new().dispatch(TapeExpansion { tape: self, rates });
    }
}

/// The sums of a series at a place, lane by lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeriesSums<const L: usize = 1> {
    /// The value, `sum_k c_k s^k`.
    pub value: [f64; L],
    /// The slope times `s`, `sum_k k c_k s^k`.
    pub change: [f64; L],
    /// The size of all terms, `sum_k |c_k| s^k`.
    pub size: [f64; L],
}

impl<const L: usize> Default for SeriesSums<L> {
    fn default() -> Self {
        Self { value: [0.0; L], change: [0.0; L], size: [0.0; L] }
    }
}

impl<const L: usize> SeriesSums<L> {
    /// The sums of one lane.
    pub fn of_lane(&self, lane: usize) -> SeriesSums {
        let [value, change, size] = [self.value, self.change, self.size].map(|sum| [sum[lane]]);
        SeriesSums { value, change, size }
    }
}

/// The sums of the first series of a tape by Horner's rule; it is inlined into its caller.
struct TapeSums<'a, const L: usize> {
    tape: &'a Tape<L>,
    s: &'a [f64; L],
    into: &'a mut [SeriesSums<L>],
}

impl<const L: usize> WithSimd for TapeSums<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let s = *self.s;
        for (place, sums) in self.into.iter_mut().enumerate() {
            let (mut value, mut slope, mut size) = ([0.0; L], [0.0; L], [0.0; L]);
            for coefficients in self.tape.lanes(place).iter().rev() {
                for lane in 0..L {
                    slope[lane] = slope[lane] * s[lane] + value[lane];
                    value[lane] = value[lane] * s[lane] + coefficients[lane];
                    size[lane] = size[lane] * s[lane] + coefficients[lane].abs();
                }
            }
            let change = per_lane(|lane| slope[lane] * s[lane]);
            *sums = SeriesSums { value, change, size };
        }
    }
}

/// The computation of all orders of a tape; it is inlined into its caller, so that it gets the
/// widest registers of the processor.
struct TapeExpansion<'a, const L: usize> {
    tape: &'a mut Tape<L>,
    rates: &'a [usize],
}

impl<const L: usize> WithSimd for TapeExpansion<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Tape { program, series, sides } = self.tape;
        let length = program.length;
        let mut inverse = f64::INFINITY;
        for order in 0..length {
            let numbers: &[usize] = if order == 0 { &program.numbers } else { &[] };
            // Beyond its degree a polynomial stays zero.
            let changing =
                if order > program.longest { &program.endless } else { &program.changing };
            for &place in numbers.iter().chain(changing) {
                compute(program, (sides, series), place, (order, inverse));
            }
            if order + 1 == length {
                break;
            }
            inverse = 1.0 / (order + 1) as f64;
            for (variable, rate) in self.rates.iter().enumerate() {
                let rate = series[rate * length + order];
                series[variable * length + order + 1] = per_lane(|lane| inverse * rate[lane]);
                if let Some(slope) = program.slopes[variable] {
                    series[slope * length + order + 1] = rate;
                }
            }
        }
    }
}

#[inline(always)]
fn per_lane<const L: usize>(value: impl Fn(usize) -> f64) -> [f64; L] {
    let mut result = [0.0; L];
    for (lane, entry) in result.iter_mut().enumerate() {
        *entry = value(lane);
    }
    result
}

/// Computes the coefficient of order `n` of the series at a place; `inverse` is `1/n`.
#[inline(always)]
fn compute<const L: usize>(
    program: &Program,
    (sides, series): (&[[f64; L]], &mut [[f64; L]]),
    place: usize,
    (n, inverse): (usize, f64),
) {
    let length = program.length;
    let row = |place: usize| &series[place * length..][..length];
    let at = |place: usize, order: usize| series[place * length + order];
    let coefficient = match &program.operations[place] {
        Operation::Given | Operation::SecondWave => return,
        Operation::Sum(terms) => {
            let mut sum = [0.0; L];
            for (weight, place) in terms {
                let (weight, term) = (at(*weight, 0), at(*place, n));
                for lane in 0..L {
                    sum[lane] += weight[lane] * term[lane];
                }
            }
            sum
        }
        Operation::Multiply(a, b, usize::MAX) if a == b => square(row(*a), n),
        Operation::Multiply(a, b, degree) => products(row(*a), row(*b), 0..n.min(*degree) + 1, n),
        Operation::Divide(a, b, degree) => {
            let known = products(row(*b), row(place), 1..n.min(*degree) + 1, n);
            let (a, b) = (at(*a, n), at(*b, 0));
            per_lane(|lane| (a[lane] - known[lane]) / b[lane])
        }
        Operation::Slope(a) => {
            let a = at(*a, n);
            per_lane(|lane| n as f64 * a[lane])
        }
        Operation::Power { base, exponent, first } if n == 0 => {
            let base = at(*base, 0);
            per_lane(|lane| first(base[lane], *exponent))
        }
        Operation::Power { base, exponent, .. } => {
            let (base, own) = (row(*base), row(place));
            let mut sum = [-0.0; L];
            let mut vanishes = [*exponent > 0.0 && n > 0; L];
            for k in 0..=n {
                let weight = exponent * k as f64 - (n - k) as f64;
                for lane in 0..L {
                    vanishes[lane] &= base[k][lane] == 0.0;
                    if k > 0 {
                        sum[lane] += weight * base[k][lane] * own[n - k][lane];
                    }
                }
            }
            // The root of a series that vanishes identically, as on the zero side of a corner, is
            // zero.
            per_lane(|lane| match vanishes[lane] {
                true => 0.0,
                false => sum[lane] / (n as f64 * base[0][lane]),
            })
        }
        Operation::Integral { of, first, .. } | Operation::Quotient { of, first, .. } if n == 0 => {
            let of = at(*of, 0);
            per_lane(|lane| first(of[lane]))
        }
        Operation::Integral { slope, degree, rate, .. } => {
            let sum = products(row(*slope), row(*rate), 1..n.min(*degree) + 1, n);
            per_lane(|lane| inverse * sum[lane])
        }
        Operation::Quotient { slope, own, over, sign, .. } => {
            let known = products(row(*own), row(*over), 1..n, n);
            let (slope, over) = (at(*slope, n), at(*over, 0));
            per_lane(|lane| (sign * slope[lane] - known[lane]) * inverse / over[lane])
        }
        Operation::Waves { of, slope, degree, sign, first } => {
            let [one, other] = match n {
                0 => {
                    let of = at(*of, 0);
                    first.map(|first| per_lane(|lane| first(of[lane])))
                }
                _ => {
                    let orders = 1..n.min(*degree) + 1;
                    let others = [row(place + 1), row(place)];
                    let [one, other] = products_with(row(*slope), others, orders, n);
                    [
                        per_lane(|lane| inverse * one[lane]),
                        per_lane(|lane| sign * inverse * other[lane]),
                    ]
                }
            };
            series[(place + 1) * length + n] = other;
            one
        }
        Operation::Choose { corner, positive, negative } => {
            let (argument, side) = (at(program.corners[*corner], 0), sides[*corner]);
            let [positive, negative] =
                [positive, negative].map(|chosen| chosen.map_or([0.0; L], |chosen| at(chosen, n)));
            per_lane(|lane| match argument[lane].is_finite() {
                true if side[lane] > 0.0 => positive[lane],
                true => negative[lane],
                // An argument without a value has no side.
                false => f64::NAN,
            })
        }
    };
    series[place * length + n] = coefficient;
}

/// `sum_k a_k b_(n-k)` over these orders.
#[inline(always)]
fn products<const L: usize>(
    a: &[[f64; L]],
    b: &[[f64; L]],
    orders: Range<usize>,
    n: usize,
) -> [f64; L] {
    let [sum] = products_with(a, [b], orders, n);
    sum
}

/// Computes [`products`] of one series with several others.
///
/// The terms at both ends have the newest coefficients and are added last: the sum of the others need
/// not wait until these are known.
#[inline(always)]
fn products_with<const L: usize, const M: usize>(
    a: &[[f64; L]],
    others: [&[[f64; L]]; M],
    orders: Range<usize>,
    n: usize,
) -> [[f64; L]; M] {
    if orders.is_empty() {
        return [[0.0; L]; M];
    }
    let a = &a[orders.clone()];
    let others = others.map(|other| &other[n + 1 - orders.end..=n - orders.start]);
    let last = a.len() - 1;
    if last == 0 {
        return others.map(|b| per_lane(|lane| a[0][lane] * b[0][lane]));
    }
    let inner = inner_products(&a[1..last], others.map(|b| &b[1..last]));
    let mut sums = [[0.0; L]; M];
    for ((sum, inner), b) in sums.iter_mut().zip(inner).zip(others) {
        *sum = per_lane(|lane| {
            inner[lane] + (a[0][lane] * b[last][lane] + a[last][lane] * b[0][lane])
        });
    }
    sums
}

/// `sum_k a_k b_(n-k) ` of lists of the same length with others, each as two independent sums of even
/// and odd k, so that one addition need not wait for the other.
#[inline(always)]
fn inner_products<const L: usize, const M: usize>(
    a: &[[f64; L]],
    others: [&[[f64; L]]; M],
) -> [[f64; L]; M] {
    let (mut even, mut odd) = ([[0.0; L]; M], [[0.0; L]; M]);
    let (pairs, mut backwards) = (a.chunks_exact(2), others.map(|b| b.rchunks_exact(2)));
    for a in pairs.clone() {
        for (index, b) in backwards.iter_mut().enumerate() {
            let Some(b) = b.next() else { continue };
            for lane in 0..L {
                even[index][lane] += a[0][lane] * b[1][lane];
                odd[index][lane] += a[1][lane] * b[0][lane];
            }
        }
    }
    if let [a] = pairs.remainder() {
        for (even, b) in even.iter_mut().zip(others) {
            for lane in 0..L {
                even[lane] += a[lane] * b[0][lane];
            }
        }
    }
    let mut sums = [[0.0; L]; M];
    for (sum, (even, odd)) in sums.iter_mut().zip(even.iter().zip(&odd)) {
        *sum = per_lane(|lane| even[lane] + odd[lane]);
    }
    sums
}

/// `sum_(k=0..n) a_k a_(n-k)`, each product once.
#[inline(always)]
fn square<const L: usize>(a: &[[f64; L]], n: usize) -> [f64; L] {
    let half = n.div_ceil(2);
    let twice = match half {
        0 => [0.0; L],
        _ => {
            let [inner] = inner_products(&a[1..half], [&a[n + 1 - half..n]]);
            per_lane(|lane| 2.0 * (inner[lane] + a[0][lane] * a[n][lane]))
        }
    };
    match n % 2 {
        0 => per_lane(|lane| twice[lane] + a[n / 2][lane] * a[n / 2][lane]),
        _ => twice,
    }
}

//! Right sides as a list of recurrences: the Taylor coefficients of every part, order by order, each part once.
//!
//! Reference: A. Griewank, A. Walther, *Evaluating Derivatives*, 2nd ed., SIAM 2008, chapter 13. With `u = u_0 + u_1 s + ...`:
//!
//! ```text
//! (u v)_n = sum_k u_k v_(n-k)            p = u^a:   n u_0 p_n = sum_(k=1..n) (a k - n + k) u_k p_(n-k)
//! q = u/v:  v_0 q_n = u_n - sum_(k=1..n) v_k q_(n-k)
//! y with y' = u' g:   n y_n = sum_(k=1..n) k u_k g_(n-k)       exp: g = y;  tan: g = 1 + y^2;  sin: g = cos;  log: u y' = u'
//! ```

use std::collections::{BTreeMap, HashMap};

use num_traits::{Signed, ToPrimitive};

use super::SystemError;
use super::polynomial::first_root;
use crate::exact::Rational;
use crate::exact::rational::to_f64;
use crate::expr::{Expr, Function, Node};
use crate::symbol::Symbol;

/// Operands are places of series.
#[derive(Clone, Copy, Debug)]
enum Operation {
    /// A state, time, or a constant: nothing to compute.
    Given,
    Add(usize, usize),
    Scale(f64, usize),
    Multiply(usize, usize),
    Divide(usize, usize),
    /// A power that is no whole number, of what is not zero; whether it is negative where the base is.
    Power {
        base: usize,
        exponent: f64,
        first: fn(f64, f64) -> f64,
    },
    Log(usize),
    /// `y' = u' g`, times a sign; begins with the value of a function.
    Integral {
        of: usize,
        rate: usize,
        sign: f64,
        first: fn(f64) -> f64,
    },
    /// One of two series, by the side of a corner; zero where there is none.
    Choose {
        corner: usize,
        positive: Option<usize>,
        negative: Option<usize>,
    },
}

/// Where a right side has another formula on either side: the sign of a series, and the side on which the motion is.
#[derive(Clone, Copy, Debug)]
struct Corner {
    argument: usize,
    side: f64,
}

/// The right sides, with the coefficients of their parts about one point.
#[derive(Clone, Debug)]
pub(super) struct Tape {
    states: Vec<Symbol>,
    time: Symbol,
    numbers: BTreeMap<Symbol, f64>,
    length: usize,
    operations: Vec<Operation>,
    /// `length` coefficients for each operation.
    series: Vec<f64>,
    known: HashMap<Expr, usize>,
    outputs: Vec<usize>,
    corners: Vec<Corner>,
}

/// The real root of an odd degree: the sign of the base is kept, or lost in an even power.
fn odd(base: f64, exponent: f64) -> f64 {
    base.abs().powf(exponent).copysign(base)
}

fn even(base: f64, exponent: f64) -> f64 {
    base.abs().powf(exponent)
}

impl Tape {
    pub(super) fn new(states: &[Symbol], time: Symbol, numbers: &BTreeMap<Symbol, f64>, order: usize) -> Self {
        let mut tape = Self {
            states: states.to_vec(),
            time,
            numbers: numbers.clone(),
            length: order + 1,
            operations: vec![],
            series: vec![],
            known: HashMap::new(),
            outputs: vec![],
            corners: vec![],
        };
        for _ in 0..=states.len() {
            tape.emit(Operation::Given);
        }
        tape
    }

    /// Adds an expression as an output.
    pub(super) fn add(&mut self, expression: &Expr) -> Result<(), SystemError> {
        let place = expression.fold(|expr, children: &[usize]| self.node(expr, children))?;
        self.outputs.push(place);
        Ok(())
    }

    fn emit(&mut self, operation: Operation) -> usize {
        self.operations.push(operation);
        self.series.resize(self.operations.len() * self.length, 0.0);
        self.operations.len() - 1
    }

    fn constant(&mut self, value: f64) -> usize {
        let place = self.emit(Operation::Given);
        self.series[place * self.length] = value;
        place
    }

    fn node(&mut self, expr: &Expr, children: &[usize]) -> Result<usize, SystemError> {
        if let Some(place) = self.known.get(expr) {
            return Ok(*place);
        }
        let place = match (expr.node(), children) {
            (Node::Number(number), _) => self.constant(to_f64(number)),
            (Node::Pi, _) => self.constant(std::f64::consts::PI),
            (Node::Symbol(symbol), _) => self.symbol(*symbol)?,
            (Node::Sum(_), [first, rest @ ..]) => rest
                .iter()
                .fold(*first, |sum, term| self.emit(Operation::Add(sum, *term))),
            (Node::Product(coefficient, factors), _) => self.product(coefficient, factors, children),
            (Node::Power(_, exponent), [base, exponent_place]) => match exponent.as_number() {
                Some(exponent) => self.power(*base, exponent),
                None => {
                    let logarithm = self.emit(Operation::Log(*base));
                    let product = self.emit(Operation::Multiply(*exponent_place, logarithm));
                    self.exponential(product)
                }
            },
            (Node::Function(function, _), [first, ..]) => {
                self.function(*function, *first, children.get(1).copied().unwrap_or(*first))?
            }
            (Node::Sum(_) | Node::Power(..) | Node::Function(..), _) => self.constant(f64::NAN),
        };
        self.known.insert(expr.clone(), place);
        Ok(place)
    }

    fn symbol(&mut self, symbol: Symbol) -> Result<usize, SystemError> {
        if let Some(place) = self.states.iter().position(|state| *state == symbol) {
            return Ok(place);
        }
        if symbol == self.time {
            return Ok(self.states.len());
        }
        match self.numbers.get(&symbol) {
            Some(number) => Ok(self.constant(*number)),
            None => Err(SystemError::Unknown(symbol)),
        }
    }

    fn product(&mut self, coefficient: &Rational, factors: &[Expr], places: &[usize]) -> usize {
        // A step gates the others: where it is zero they need no value.
        let is_gate = |expr: &Expr| matches!(expr.node(), Node::Function(Function::Step, _));
        let mut product: Option<usize> = None;
        for (_, place) in factors.iter().zip(places).filter(|(factor, _)| !is_gate(factor)) {
            product = Some(match product {
                None => *place,
                Some(product) => self.emit(Operation::Multiply(product, *place)),
            });
        }
        let coefficient = to_f64(coefficient);
        let mut product = match product {
            None => self.constant(coefficient),
            Some(product) if coefficient == 1.0 => product,
            Some(product) => self.emit(Operation::Scale(coefficient, product)),
        };
        for (_, place) in factors.iter().zip(places).filter(|(factor, _)| is_gate(factor)) {
            if let Operation::Choose { corner, .. } = self.operations[*place] {
                product = self.emit(Operation::Choose {
                    corner,
                    positive: Some(product),
                    negative: None,
                });
            }
        }
        product
    }

    fn power(&mut self, base: usize, exponent: &Rational) -> usize {
        const LARGEST_CHAIN: u32 = 1 << 14;
        let whole = exponent.is_integer().then(|| exponent.numer().abs().to_u32()).flatten();
        if let Some(mut left) = whole.filter(|whole| *whole <= LARGEST_CHAIN) {
            let (mut square, mut result) = (base, None);
            while left > 0 {
                if left % 2 == 1 {
                    result = Some(match result {
                        None => square,
                        Some(result) => self.emit(Operation::Multiply(result, square)),
                    });
                }
                left /= 2;
                if left > 0 {
                    square = self.emit(Operation::Multiply(square, square));
                }
            }
            let one = self.constant(1.0);
            let result = result.unwrap_or(one);
            return match exponent.is_negative() {
                true => self.emit(Operation::Divide(one, result)),
                false => result,
            };
        }
        let is_odd = |number: &crate::exact::Integer| number % 2_u32 != 0_u32.into();
        let first = match (is_odd(exponent.denom()), is_odd(exponent.numer())) {
            (true, true) => odd,
            (true, false) => even,
            (false, _) => f64::powf,
        };
        self.emit(Operation::Power {
            base,
            exponent: to_f64(exponent),
            first,
        })
    }

    fn exponential(&mut self, of: usize) -> usize {
        let rate = self.operations.len();
        self.emit(Operation::Integral {
            of,
            rate,
            sign: 1.0,
            first: f64::exp,
        })
    }

    /// Two functions, each the rate of the other.
    fn pair(&mut self, of: usize, first: [fn(f64) -> f64; 2], sign: f64) -> [usize; 2] {
        let place = self.operations.len();
        let [one, other] = first;
        let function = self.emit(Operation::Integral {
            of,
            rate: place + 1,
            sign: 1.0,
            first: one,
        });
        let partner = self.emit(Operation::Integral {
            of,
            rate: place,
            sign,
            first: other,
        });
        [function, partner]
    }

    /// `y' = u' (1 + sign*y^2)`: tangents.
    fn tangent(&mut self, of: usize, sign: f64, first: fn(f64) -> f64) -> usize {
        let place = self.operations.len();
        let tangent = self.emit(Operation::Integral {
            of,
            rate: place + 3,
            sign: 1.0,
            first,
        });
        let square = self.emit(Operation::Multiply(tangent, tangent));
        let scaled = self.emit(Operation::Scale(sign, square));
        // The number one would come after its first use: its place is the rate's own, begun with it.
        let one = place + 4;
        self.emit(Operation::Add(scaled, one));
        self.constant(1.0);
        tangent
    }

    /// `y' = u' (1 + sign*u^2)^exponent`: inverse functions.
    fn inverse(&mut self, of: usize, [square_sign, exponent, sign]: [f64; 3], first: fn(f64) -> f64) -> usize {
        let square = self.emit(Operation::Multiply(of, of));
        let scaled = self.emit(Operation::Scale(square_sign, square));
        let one = self.constant(1.0);
        let base = self.emit(Operation::Add(one, scaled));
        let rate = self.emit(Operation::Power {
            base,
            exponent,
            first: f64::powf,
        });
        self.emit(Operation::Integral { of, rate, sign, first })
    }

    fn choose(&mut self, argument: usize, positive: Option<usize>, negative: Option<usize>) -> usize {
        self.corners.push(Corner { argument, side: 1.0 });
        self.emit(Operation::Choose {
            corner: self.corners.len() - 1,
            positive,
            negative,
        })
    }

    fn function(&mut self, function: Function, u: usize, v: usize) -> Result<usize, SystemError> {
        Ok(match function {
            Function::Sin => self.pair(u, [f64::sin, f64::cos], -1.0)[0],
            Function::Cos => self.pair(u, [f64::sin, f64::cos], -1.0)[1],
            Function::Sinh => self.pair(u, [f64::sinh, f64::cosh], 1.0)[0],
            Function::Cosh => self.pair(u, [f64::sinh, f64::cosh], 1.0)[1],
            Function::Tan => self.tangent(u, 1.0, f64::tan),
            Function::Tanh => self.tangent(u, -1.0, f64::tanh),
            Function::Exp => self.exponential(u),
            Function::Log => self.emit(Operation::Log(u)),
            Function::Atan => self.inverse(u, [1.0, -1.0, 1.0], f64::atan),
            Function::Asin => self.inverse(u, [-1.0, -0.5, 1.0], f64::asin),
            Function::Acos => self.inverse(u, [-1.0, -0.5, -1.0], f64::acos),
            Function::Absolute => {
                let minus = self.emit(Operation::Scale(-1.0, u));
                self.choose(u, Some(u), Some(minus))
            }
            Function::Sign => {
                let (one, minus) = (self.constant(1.0), self.constant(-1.0));
                self.choose(u, Some(one), Some(minus))
            }
            Function::Step => {
                let one = self.constant(1.0);
                self.choose(u, Some(one), None)
            }
            Function::Maximum | Function::Minimum => {
                let minus = self.emit(Operation::Scale(-1.0, v));
                let difference = self.emit(Operation::Add(u, minus));
                let [larger, smaller] = [Some(u), Some(v)];
                match function {
                    Function::Maximum => self.choose(difference, larger, smaller),
                    _ => self.choose(difference, smaller, larger),
                }
            }
            special => return Err(SystemError::Function(special.name())),
        })
    }

    /// Takes the side of every corner on which this point lies, or to which it is going.
    pub(super) fn begin(&mut self, time: f64, values: &[f64]) {
        // The argument of one corner may depend on the side of another.
        for _ in 0..=self.corners.len() {
            // Parts without a value on a side not taken yet do not matter here.
            let _ = self.expand_once(time, values);
            for index in 0..self.corners.len() {
                let series = self.series_of(self.corners[index].argument);
                if let Some(first) = series.iter().find(|value| value.is_finite() && **value != 0.0) {
                    self.corners[index].side = first.signum();
                }
            }
        }
    }

    /// The coefficients of everything about a point.
    ///
    /// # Errors
    /// The first state whose series has no finite value.
    pub(super) fn expand(&mut self, time: f64, values: &[f64]) -> Result<(), usize> {
        for _ in 0..=self.corners.len() {
            let result = self.expand_once(time, values);
            // A corner left behind together with another: the motion is beyond it and going on.
            let left = (0..self.corners.len()).find(|&index| {
                let Corner { argument, side } = self.corners[index];
                let series = self.series_of(argument);
                let slope = series.get(1).copied().unwrap_or(0.0);
                series[0] * side < 0.0 && slope * side < 0.0
            });
            match left {
                Some(index) => self.cross(index),
                None => return result,
            }
        }
        self.expand_once(time, values)
    }

    fn expand_once(&mut self, time: f64, values: &[f64]) -> Result<(), usize> {
        let (length, size) = (self.length, self.states.len());
        for (state, value) in values.iter().enumerate() {
            self.series[state * length] = *value;
        }
        self.series[size * length] = time;
        if length > 1 {
            self.series[size * length + 1] = 1.0;
        }
        for n in 0..length {
            for place in 0..self.operations.len() {
                if let Some(coefficient) = self.coefficient(place, n) {
                    self.series[place * length + n] = coefficient;
                }
            }
            if n + 1 < length {
                for state in 0..size {
                    let rate = self.series[self.outputs[state] * length + n];
                    self.series[state * length + n + 1] = rate / (n + 1) as f64;
                }
            }
        }
        match (0..size).find(|&state| self.state(state).iter().any(|value| !value.is_finite())) {
            Some(state) => Err(state),
            None => Ok(()),
        }
    }

    /// The coefficient of order `n`, where it has to be computed.
    fn coefficient(&self, place: usize, n: usize) -> Option<f64> {
        let of = |place: usize| self.series_of(place);
        let divided = n as f64;
        Some(match self.operations[place] {
            Operation::Given => return None,
            Operation::Add(a, b) => of(a)[n] + of(b)[n],
            Operation::Scale(factor, a) => factor * of(a)[n],
            Operation::Multiply(a, b) => {
                let (a, b) = (&of(a)[..=n], &of(b)[..=n]);
                a.iter().zip(b.iter().rev()).map(|(a, b)| a * b).sum()
            }
            Operation::Divide(a, b) => {
                let (a, b, q) = (of(a), of(b), of(place));
                let known: f64 = (1..=n).map(|k| b[k] * q[n - k]).sum();
                (a[n] - known) / b[0]
            }
            Operation::Power { base, exponent, first } => {
                let (u, p) = (of(base), of(place));
                match n {
                    0 => first(u[0], exponent),
                    _ => {
                        let term = |k: usize| (exponent * k as f64 - (n - k) as f64) * u[k] * p[n - k];
                        (1..=n).map(term).sum::<f64>() / (divided * u[0])
                    }
                }
            }
            Operation::Log(a) => {
                let (u, l) = (of(a), of(place));
                match n {
                    0 => u[0].ln(),
                    _ => {
                        let known: f64 = (1..n).map(|k| k as f64 * l[k] * u[n - k]).sum();
                        (divided * u[n] - known) / (divided * u[0])
                    }
                }
            }
            Operation::Integral {
                of: u,
                rate,
                sign,
                first,
            } => {
                let (u, g) = (of(u), of(rate));
                match n {
                    0 => first(u[0]),
                    _ => sign * (1..=n).map(|k| k as f64 * u[k] * g[n - k]).sum::<f64>() / divided,
                }
            }
            Operation::Choose {
                corner,
                positive,
                negative,
            } => {
                let chosen = if self.corners[corner].side > 0.0 {
                    positive
                } else {
                    negative
                };
                chosen.map_or(0.0, |chosen| of(chosen)[n])
            }
        })
    }

    fn series_of(&self, place: usize) -> &[f64] {
        &self.series[place * self.length..(place + 1) * self.length]
    }

    /// The series of a state.
    pub(super) fn state(&self, state: usize) -> &[f64] {
        self.series_of(state)
    }

    /// The series of an output, in the order in which they were added.
    pub(super) fn output(&self, output: usize) -> &[f64] {
        self.series_of(self.outputs[output])
    }

    /// The longest step within the tolerance, by the last orders of every state: several, since symmetry may leave some of them
    /// zero.
    pub(super) fn step(&self, tolerance: f64) -> f64 {
        const LAST: usize = 8;
        const SHORTER: f64 = 0.9;
        const TRIALS: usize = 400;
        let order = self.length - 1;
        let last = order.saturating_sub(LAST - 1).max(1)..=order;
        let mut longest = f64::INFINITY;
        for state in 0..self.states.len() {
            let series = self.state(state);
            let Some(first) = series.iter().position(|c| *c != 0.0) else {
                continue;
            };
            let term = |k: usize, h: f64| series[k].abs() * h.powi(k as i32);
            let within = |h: f64| {
                let size = (0..=order / 2).map(|k| term(k, h)).fold(0.0, f64::max);
                let kept = |k: usize| term(k, h) <= size * tolerance.powf(k as f64 / order as f64);
                last.clone().all(kept)
            };
            // The root test; from there shorter until the last terms are small enough.
            let radius = |k: usize| (series[first].abs() / series[k].abs()).powf(1.0 / (k - first) as f64);
            let radii = last.clone().filter(|&k| k > first && series[k] != 0.0).map(radius);
            let mut h = radii.fold(longest, f64::min);
            if h.is_infinite() {
                continue;
            }
            for _ in 0..TRIALS {
                if within(h) {
                    break;
                }
                h *= SHORTER;
            }
            longest = h;
        }
        longest
    }

    /// The first corner met within a step, and where; at 0 where the motion turns back to the corner that it stands on.
    pub(super) fn first_corner(&self, length: f64) -> Option<(usize, f64)> {
        let met = |(index, corner): (usize, &Corner)| {
            let series = self.series_of(corner.argument);
            let (here, slope) = (
                corner.side * series[0],
                corner.side * series.get(1).copied().unwrap_or(0.0),
            );
            let rounding = 1e-14 * length * slope.abs();
            if here <= rounding && slope < 0.0 {
                return Some((index, 0.0));
            }
            let mut from = 0.0;
            while let Some((place, rising)) = first_root(series, from, length) {
                if rising != (corner.side > 0.0) {
                    return Some((index, place));
                }
                from = place;
            }
            None
        };
        let found = self.corners.iter().enumerate().filter_map(met);
        found.min_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// Goes to the other side of a corner, and of all others with the same argument.
    pub(super) fn cross(&mut self, corner: usize) {
        let Corner { argument, side } = self.corners[corner];
        for corner in self.corners.iter_mut().filter(|corner| corner.argument == argument) {
            corner.side = -side;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{CompiledFunction, parse_expression};
    use crate::system::polynomial::value;

    /// The series of an expression along x = 0.7 + t is its Taylor series: its sum is its value.
    #[test]
    fn every_recurrence_sums_to_its_function() {
        let (x, t) = (Symbol::new("x"), Symbol::new("t"));
        for text in [
            "x^3 - 2*x + 1/x^2 + t*x",
            "sin(x)*cos(2*x) + tan(x)",
            "sinh(x) - cosh(x)*tanh(x)",
            "exp(-x^2) + log(1 + x)*sqrt(2 + x)",
            "asin(x/3) + acos(x/4)*atan(x)",
            "abs(x - 3) + sgn(x)*max(x, x^2/100) + min(x, 7) + H(x)*x + H(x - 3)*(x - 3)^(3/2)",
            "(1 + x)^x + x^(7/3) + (-x)^(1/3) + (-x)^(2/3) + 3",
        ] {
            let expression = parse_expression(text).expect(text);
            let mut tape = Tape::new(&[x], t, &BTreeMap::new(), 40);
            tape.add(&Expr::one()).expect("a rate");
            tape.add(&expression).expect(text);
            tape.begin(0.2, &[0.7]);
            tape.expand(0.2, &[0.7]).expect("a series");
            let exact = CompiledFunction::new(&expression, &[x, t]).expect(text);
            for s in [-0.05, 0.03, 0.09] {
                let (sum, expected) = (value(tape.output(1), s), exact.call(&[0.7 + s, 0.2 + s]));
                assert!(
                    (sum - expected).abs() < 1e-13 * (1.0 + expected.abs()),
                    "{text} at {s}: {sum} {expected}"
                );
            }
        }
    }
}

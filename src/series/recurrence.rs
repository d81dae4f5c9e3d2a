//! Taylor coefficients as floating-point numbers: an expression as a list of recurrences, computed order by order, each part once.
//!
//! In: the names of the variables, numbers for every other symbol, expressions. Out: the series of each expression, one order
//! beyond those of the variables given so far, so that a differential equation can feed its rates back; or, by
//! [`numeric_taylor`], the series in one variable.
//!
//! References: A. Griewank, A. Walther, *Evaluating Derivatives*, 2nd ed., SIAM 2008, chapter 13; E. Hairer, S. P. Norsett,
//! G. Wanner, *Solving Ordinary Differential Equations I*, 2nd ed., section I.8. With `u = u_0 + u_1 s + ...`:
//!
//! ```text
//! (u v)_n = sum_k u_k v_(n-k)            p = u^a:   n u_0 p_n = sum_(k=1..n) (a k - n + k) u_k p_(n-k)
//! q = u/v:  v_0 q_n = u_n - sum_(k=1..n) v_k q_(n-k)
//! y with y' = u' g:   n y_n = sum_(k=1..n) k u_k g_(n-k)       exp: g = y;  tan: g = 1 + y^2;  sin: g = cos;  log: u y' = u'
//! ```

use std::collections::{BTreeMap, HashMap};

use num_traits::{Signed, ToPrimitive};

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

/// Where an expression has another formula on either side: the sign of a series, and the side that is taken.
#[derive(Clone, Copy, Debug)]
struct Corner {
    argument: usize,
    side: f64,
}

/// Why an expression has no recurrence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RecurrenceError {
    /// A name without a value.
    #[error("`{0}` is neither a variable nor a number")]
    Unknown(Symbol),
    /// A function of answers, without a recurrence.
    #[error("`{0}` cannot be part of an equation: it occurs in answers alone")]
    Function(&'static str),
}

/// Expressions in some variables, with the coefficients of all their parts about one point.
///
/// A series is named by its place: the variables come first, in their order; [`add`](Self::add) says where the others are.
#[derive(Clone, Debug)]
pub struct Recurrences {
    variables: Vec<Symbol>,
    numbers: BTreeMap<Symbol, f64>,
    length: usize,
    operations: Vec<Operation>,
    /// `length` coefficients for each operation.
    series: Vec<f64>,
    known: HashMap<Expr, usize>,
    /// Sine and cosine of a series, or their hyperbolic sisters: who has one has the other.
    waves: HashMap<(usize, bool), [usize; 2]>,
    corners: Vec<Corner>,
}

/// The real root of an odd degree: the sign of the base is kept, or lost in an even power.
fn odd(base: f64, exponent: f64) -> f64 {
    base.abs().powf(exponent).copysign(base)
}

fn even(base: f64, exponent: f64) -> f64 {
    base.abs().powf(exponent)
}

impl Recurrences {
    /// Series up to `s^degree` in these variables; `numbers` has the value of every other symbol.
    pub fn new(variables: &[Symbol], numbers: &BTreeMap<Symbol, f64>, degree: usize) -> Self {
        let mut recurrences = Self {
            variables: variables.to_vec(),
            numbers: numbers.clone(),
            length: degree + 1,
            operations: vec![],
            series: vec![],
            known: HashMap::new(),
            waves: HashMap::new(),
            corners: vec![],
        };
        for _ in variables {
            recurrences.emit(Operation::Given);
        }
        recurrences
    }

    /// Adds an expression; answers the place of its series.
    ///
    /// # Errors
    /// A symbol without a value, a function without a recurrence.
    pub fn add(&mut self, expression: &Expr) -> Result<usize, RecurrenceError> {
        expression.fold(|expr, children: &[usize]| self.node(expr, children))
    }

    /// Sets a coefficient, of a variable.
    pub fn set(&mut self, place: usize, order: usize, value: f64) {
        self.series[place * self.length + order] = value;
    }

    /// Computes the coefficients of this order of everything, where those of the variables and all lower ones are known.
    pub fn compute(&mut self, order: usize) {
        for place in 0..self.operations.len() {
            if let Some(coefficient) = self.coefficient(place, order) {
                self.set(place, order, coefficient);
            }
        }
    }

    /// The series at a place; what has no value is not a finite number.
    pub fn series(&self, place: usize) -> &[f64] {
        &self.series[place * self.length..(place + 1) * self.length]
    }

    /// The series whose signs choose between formulas (`abs`, `sgn`, `H`, `max`, `min`), and on which side of zero they are
    /// taken to be.
    pub fn corners(&self) -> impl Iterator<Item = (&[f64], f64)> {
        let argument = |corner: &Corner| (self.series(corner.argument), corner.side);
        self.corners.iter().map(argument)
    }

    /// Takes the other side of a corner, by its number in [`corners`](Self::corners).
    pub fn cross(&mut self, corner: usize) {
        self.corners[corner].side *= -1.0;
    }

    /// Takes the side of every corner on which its series lies, or to which it is going; whether one of them is another now.
    pub fn take_sides(&mut self) -> bool {
        let mut changed = false;
        for index in 0..self.corners.len() {
            let Corner { argument, side } = self.corners[index];
            let first = self
                .series(argument)
                .iter()
                .find(|value| value.is_finite() && **value != 0.0);
            if let Some(first) = first.filter(|first| first.signum() != side) {
                self.corners[index].side = first.signum();
                changed = true;
            }
        }
        changed
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

    fn node(&mut self, expr: &Expr, children: &[usize]) -> Result<usize, RecurrenceError> {
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

    fn symbol(&mut self, symbol: Symbol) -> Result<usize, RecurrenceError> {
        if let Some(place) = self.variables.iter().position(|variable| *variable == symbol) {
            return Ok(place);
        }
        match self.numbers.get(&symbol) {
            Some(number) => Ok(self.constant(*number)),
            None => Err(RecurrenceError::Unknown(symbol)),
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
        let whole = exponent.is_integer().then(|| exponent.numer().abs().to_u64()).flatten();
        if let Some(mut left) = whole {
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

    /// Sine and cosine, each the rate of the other, or their hyperbolic sisters.
    fn waves(&mut self, of: usize, hyperbolic: bool) -> [usize; 2] {
        if let Some(places) = self.waves.get(&(of, hyperbolic)) {
            return *places;
        }
        let first: [fn(f64) -> f64; 2] = match hyperbolic {
            true => [f64::sinh, f64::cosh],
            false => [f64::sin, f64::cos],
        };
        let sign = if hyperbolic { 1.0 } else { -1.0 };
        let places = [self.operations.len(), self.operations.len() + 1];
        for (part, sign) in [1.0, sign].into_iter().enumerate() {
            self.emit(Operation::Integral {
                of,
                rate: places[1 - part],
                sign,
                first: first[part],
            });
        }
        self.waves.insert((of, hyperbolic), places);
        places
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
        let same = self.corners.iter().position(|corner| corner.argument == argument);
        let corner = same.unwrap_or(self.corners.len());
        if same.is_none() {
            self.corners.push(Corner { argument, side: 1.0 });
        }
        self.emit(Operation::Choose {
            corner,
            positive,
            negative,
        })
    }

    fn function(&mut self, function: Function, u: usize, v: usize) -> Result<usize, RecurrenceError> {
        Ok(match function {
            Function::Sin => self.waves(u, false)[0],
            Function::Cos => self.waves(u, false)[1],
            Function::Sinh => self.waves(u, true)[0],
            Function::Cosh => self.waves(u, true)[1],
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
            special => return Err(RecurrenceError::Function(special.name())),
        })
    }

    /// The coefficient of order `n`, where it has to be computed.
    fn coefficient(&self, place: usize, n: usize) -> Option<f64> {
        let of = |place: usize| self.series(place);
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
                let Corner { argument, side } = self.corners[corner];
                let chosen = if side > 0.0 { positive } else { negative };
                match of(argument)[0].is_finite() {
                    true => chosen.map_or(0.0, |chosen| of(chosen)[n]),
                    // Without a value it has no side.
                    false => f64::NAN,
                }
            }
        })
    }
}

/// The coefficients of `s^0` to `s^degree` of an expression with `coordinate = centre + scale*s` and no other symbol; `None`
/// where it is not analytic there, contains another symbol, or a coefficient is out of range.
pub fn numeric_taylor(expr: &Expr, coordinate: Symbol, centre: f64, scale: f64, degree: usize) -> Option<Vec<f64>> {
    let mut recurrences = Recurrences::new(&[coordinate], &BTreeMap::new(), degree);
    let place = recurrences.add(expr).ok()?;
    recurrences.set(0, 0, centre);
    if degree > 0 {
        recurrences.set(0, 1, scale);
    }
    // The argument of one corner may depend on the side of another.
    for _ in 0..=recurrences.corners.len() {
        (0..=degree).for_each(|order| recurrences.compute(order));
        if !recurrences.take_sides() {
            break;
        }
    }
    // On a corner itself there is no series.
    let series = recurrences.series(place);
    let analytic = recurrences.corners().all(|(argument, _)| argument[0] != 0.0);
    (analytic && series.iter().all(|value| value.is_finite())).then(|| series.to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{CompiledFunction, parse_expression};

    #[test]
    fn the_series_is_the_function() {
        let x: Symbol = "x".into();
        for text in [
            "x^3 - 2*x + 1/x^2",
            "sin(x)*cos(2*x) + tan(x)",
            "sinh(x) - cosh(x)*tanh(x)",
            "exp(-x^2) + log(1 + x)*sqrt(2 + x)",
            "asin(x/3) + acos(x/4)*atan(x)",
            "abs(x - 3) + sgn(x)*max(x, x^2/100) + min(x, 7) + H(x)*x + H(x - 3)*(x - 3)^(3/2)",
            "(1 + x)^x + x^(7/3) + (-x)^(1/3) + (-x)^(2/3) + asin(sin(x)) + 3",
        ] {
            let expression = parse_expression(text).expect(text);
            let function = CompiledFunction::new(&expression, &[x]).expect(text);
            let series = numeric_taylor(&expression, x, 0.7, 0.1, 40).expect(text);
            for s in [-0.5_f64, 0.3, 0.9] {
                let sum = series.iter().rev().fold(0.0, |sum, c| sum * s + c);
                let exact = function.call(&[0.7 + 0.1 * s]);
                assert!(
                    (sum - exact).abs() < 1e-13 * (1.0 + exact.abs()),
                    "{text} at {s}: {sum} {exact}"
                );
            }
        }
        // Among them what has no value, so that no side can be taken.
        for text in [
            "abs(x)",
            "x^(1/3)",
            "log(x)",
            "1/x",
            "k*x",
            "x*H(log(x) + 3)",
            "max(x, 1/x)",
        ] {
            let expression = parse_expression(text).expect(text);
            assert_eq!(numeric_taylor(&expression, x, 0.0, 1.0, 4), None, "{text}");
        }
        // Powers beyond the degree, where the base is zero.
        let high = parse_expression("x + x^10000").expect("powers");
        assert_eq!(numeric_taylor(&high, x, 0.0, 1.0, 2), Some(vec![0.0, 1.0, 0.0]));
    }

    /// What occurs twice is computed once, and sine and cosine come together.
    #[test]
    fn each_part_is_computed_once() {
        let count = |texts: &[&str]| {
            let mut recurrences = Recurrences::new(&["x".into()], &BTreeMap::new(), 1);
            for text in texts {
                recurrences.add(&parse_expression(text).expect(text)).expect(text);
            }
            recurrences.operations.len()
        };
        assert_eq!(count(&["sin(x)"]), count(&["sin(x)", "cos(x)", "sin(x)"]));
        assert_eq!(count(&["sgn(x)*exp(x^2)", "exp(x^2)"]), count(&["sgn(x)*exp(x^2)"]));
    }
}

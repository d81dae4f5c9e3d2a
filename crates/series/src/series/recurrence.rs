//! An expression as a list of recurrences for its Taylor coefficients, in which every part occurs
//! once.
//!
//! In: the names of the variables, numbers for every other symbol, expressions. Out: a [`Tape`]
//! that computes the series of each expression, and of variables whose rates are among the
//! expressions; or, by [`numeric_taylor`], the series in one variable.
//!
//! References: A. Griewank, A. Walther, *Evaluating Derivatives*, 2nd ed., SIAM 2008, chapter 13;
//! E. Hairer, S. P. Norsett, G. Wanner, *Solving Ordinary Differential Equations I*, 2nd ed.,
//! section I.8. The recurrences themselves are in [`super::tape`].

use std::collections::{BTreeMap, HashMap};

use num_traits::{Signed, ToPrimitive};

use crate::exact::Rational;
use crate::exact::rational::to_f64;
use crate::expr::{Expr, Function, Node};
use crate::symbol::Symbol;

use super::guard::Guards;
use super::tape::{Operation, Program, Tape};

/// The reason why an expression has no recurrence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RecurrenceError {
    /// A name is neither a variable nor has a value.
    #[error("`{0}` is neither a variable nor a number")]
    Unknown(Symbol),
    /// A function that occurs only in answers has no recurrence.
    #[error("`{0}` cannot be part of an equation: it occurs in answers alone")]
    Function(&'static str),
}

/// A builder of a [`Tape`].
///
/// A series is identified by its place, an index: the variables come first, in their order;
/// [`add`](Self::add) returns the places of the others.
#[derive(Clone, Debug)]
pub struct Recurrences {
    program: Program,
    variables: Vec<Symbol>,
    numbers: BTreeMap<Symbol, f64>,
    known: HashMap<Expr, usize>,
    products: HashMap<(usize, usize), usize>,
    slopes: HashMap<usize, usize>,
    outputs: Vec<usize>,
    /// The places of sine and cosine of a series, or of the hyperbolic pair, which are computed
    /// together.
    waves: HashMap<(usize, bool), [usize; 2]>,
    /// The guards of the corners of the tape, in their order.
    guards: Guards,
}

/// The real root of odd degree to an odd power, which keeps the sign of the base; [`even_root`] is
/// for an even power.
fn odd_root(base: f64, exponent: f64) -> f64 {
    base.abs().powf(exponent).copysign(base)
}

fn even_root(base: f64, exponent: f64) -> f64 {
    base.abs().powf(exponent)
}

impl Recurrences {
    /// Series up to `s^degree` in these variables, each given with the order beyond which its
    /// series is zero: 0 for a parameter, 1 for time, `None` for any other. `numbers` has the value
    /// of every other symbol.
    pub fn new(
        variables: &[(Symbol, Option<usize>)],
        numbers: &BTreeMap<Symbol, f64>,
        degree: usize,
    ) -> Self {
        let mut program = Program::new(degree);
        for (_, degree) in variables {
            program.variable(*degree);
        }
        Self {
            program,
            variables: variables.iter().map(|(name, _)| *name).collect(),
            numbers: numbers.clone(),
            known: HashMap::new(),
            products: HashMap::new(),
            slopes: HashMap::new(),
            outputs: vec![],
            waves: HashMap::new(),
            guards: Guards::new(numbers),
        }
    }

    /// Adds an expression and returns the place of its series.
    ///
    /// # Errors
    /// [`RecurrenceError`] for a symbol without a value, or a function without a recurrence.
    pub fn add(&mut self, expression: &Expr) -> Result<usize, RecurrenceError> {
        let place = expression.fold(|expr, children: &[usize]| self.node(expr, children))?;
        self.outputs.push(place);
        Ok(place)
    }

    /// Adds a corner at which no expression changes, so that a step ends where its argument passes
    /// through zero. Returns its index among the corners.
    ///
    /// # Errors
    /// As [`Self::add`].
    pub fn watch(&mut self, argument: &Expr) -> Result<usize, RecurrenceError> {
        let place = self.add(argument)?;
        let guard = self.guards.find_or_add(argument);
        if guard.is_new {
            self.program.corners.push(place);
        }
        Ok(guard.index)
    }

    /// Returns the tape that computes the series of all outputs.
    pub fn into_tape(mut self) -> Tape {
        self.program.keep_only(&self.outputs);
        Tape::new(self.program)
    }

    fn emit(&mut self, operation: Operation) -> usize {
        self.program.emit(operation)
    }

    fn constant(&mut self, value: f64) -> usize {
        self.program.number(value)
    }

    fn multiply(&mut self, one: usize, other: usize) -> usize {
        let key = (one.min(other), one.max(other));
        if let Some(place) = self.products.get(&key) {
            return *place;
        }
        // The shorter series comes first; of two long ones the one computed later, whose last
        // coefficient is then needed last.
        let (short, long) = match self.program.degree(key.0) < self.program.degree(key.1) {
            true => key,
            false => (key.1, key.0),
        };
        let place = match self.program.is_number(short) {
            true => self.emit(Operation::Sum([(short, long)].into())),
            false => self.emit(Operation::Multiply(short, long, self.program.degree(short))),
        };
        self.products.insert(key, place);
        place
    }

    /// A sum of series, each times a factor.
    fn weighted(&mut self, terms: &[(f64, usize)]) -> usize {
        let terms = terms.iter().map(|(factor, place)| (self.constant(*factor), *place)).collect();
        self.emit(Operation::Sum(terms))
    }

    fn scale(&mut self, factor: f64, place: usize) -> usize {
        self.weighted(&[(factor, place)])
    }

    fn slope(&mut self, mut of: usize) -> usize {
        // An added number does not change the slope.
        while let Operation::Sum(terms) = self.program.operation(of) {
            let mut changing = terms.iter().filter(|(_, place)| !self.program.is_number(*place));
            match (changing.next(), changing.next()) {
                (Some((weight, place)), None) if self.program.is_one(*weight) => of = *place,
                _ => break,
            }
        }
        if let Some(place) = self.slopes.get(&of) {
            return *place;
        }
        let place = self.emit(Operation::Slope(of));
        self.slopes.insert(of, place);
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
            (Node::Sum(_), _) => self.sum(children),
            (Node::Product(coefficient, factors), _) => {
                self.product(coefficient, factors, children)
            }
            (Node::Power(_, exponent), [base, exponent_place]) => match exponent.as_number() {
                Some(exponent) => self.power(*base, exponent),
                None => {
                    let logarithm = self.quotient(*base, *base, 1.0, f64::ln);
                    let product = self.multiply(*exponent_place, logarithm);
                    self.exponential(product)
                }
            },
            (Node::Function(function, arguments), [first, ..]) => {
                let second = children.get(1).copied().unwrap_or(*first);
                match self.corner(*function, arguments, [*first, second]) {
                    Some(place) => place,
                    None => self.function(*function, *first)?,
                }
            }
            (Node::Power(..) | Node::Function(..), _) => self.constant(f64::NAN),
        };
        self.known.insert(expr.clone(), place);
        Ok(place)
    }

    fn symbol(&mut self, symbol: Symbol) -> Result<usize, RecurrenceError> {
        if let Some(place) = self.variables.iter().position(|variable| *variable == symbol) {
            return Ok(place);
        }
        match self.numbers.get(&symbol) {
            Some(number) => {
                let place = self.constant(*number);
                self.program.named.push((symbol, place));
                Ok(place)
            }
            None => Err(RecurrenceError::Unknown(symbol)),
        }
    }

    /// Adds a sum. A term that is a number times a series is merged into it, so that the sum is a
    /// single operation.
    fn sum(&mut self, places: &[usize]) -> usize {
        let mut terms = Vec::with_capacity(places.len());
        for place in places {
            match self.program.operation(*place) {
                Operation::Sum(inner) if inner.len() == 1 => terms.extend(inner.iter().copied()),
                _ => terms.push((self.constant(1.0), *place)),
            }
        }
        // The terms are sorted so that the latest result is needed last.
        terms.sort_by_key(|(_, place)| *place);
        self.emit(Operation::Sum(terms.into()))
    }

    fn product(&mut self, coefficient: &Rational, factors: &[Expr], places: &[usize]) -> usize {
        // Step functions are applied at the end as a choice: where one is zero, the other factors
        // need no value.
        let is_gate = |expr: &Expr| matches!(expr.node(), Node::Function(Function::Step, _));
        let open = factors.iter().zip(places).filter(|(factor, _)| !is_gate(factor));
        // Numbers are multiplied separately, so that the product of the other factors may be
        // shared.
        let (numbers, changing): (Vec<usize>, Vec<usize>) =
            open.map(|(_, place)| *place).partition(|place| self.program.is_number(*place));
        let mut of = |places: Vec<usize>| {
            places.into_iter().reduce(|product, place| self.multiply(product, place))
        };
        let parts = [of(numbers), of(changing)];
        let product =
            parts.into_iter().flatten().reduce(|number, changing| self.multiply(number, changing));
        let coefficient = to_f64(coefficient);
        let mut product = match product {
            None => self.constant(coefficient),
            Some(product) if coefficient == 1.0 => product,
            Some(product) => self.scale(coefficient, product),
        };
        for (_, place) in factors.iter().zip(places).filter(|(factor, _)| is_gate(factor)) {
            if let Operation::Choose { corner, positive, negative } =
                *self.program.operation(*place)
            {
                product = self.emit(Operation::Choose {
                    corner,
                    positive: positive.map(|_| product),
                    negative: negative.map(|_| product),
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
                        Some(result) => self.multiply(result, square),
                    });
                }
                left /= 2;
                if left > 0 {
                    square = self.multiply(square, square);
                }
            }
            let one = self.constant(1.0);
            let result = result.unwrap_or(one);
            return match exponent.is_negative() {
                true => self.emit(Operation::Divide(one, result, self.program.degree(result))),
                false => result,
            };
        }
        let first = match (exponent.denom().is_odd(), exponent.numer().is_odd()) {
            (true, true) => odd_root,
            (true, false) => even_root,
            (false, _) => f64::powf,
        };
        self.emit(Operation::Power { base, exponent: to_f64(exponent), first })
    }

    /// Adds `y' = u' g`, where `g` is the operation `behind` places after `y`.
    fn integral(&mut self, of: usize, behind: usize, first: fn(f64) -> f64) -> usize {
        let slope = self.slope(of);
        self.emit(Operation::Integral {
            of,
            slope,
            degree: self.program.degree(slope),
            rate: self.program.size() + behind,
            first,
        })
    }

    /// Adds `y' = u'/v`, times a sign.
    fn quotient(&mut self, of: usize, over: usize, sign: f64, first: fn(f64) -> f64) -> usize {
        let slope = self.slope(of);
        let place = self.program.size();
        self.emit(Operation::Quotient { of, slope, own: place + 1, over, sign, first });
        self.slope(place);
        place
    }

    fn exponential(&mut self, of: usize) -> usize {
        self.integral(of, 0, f64::exp)
    }

    /// Adds sine and cosine, or the hyperbolic pair, each with the other in its rate; returns both
    /// places.
    fn waves(&mut self, of: usize, hyperbolic: bool) -> [usize; 2] {
        if let Some(places) = self.waves.get(&(of, hyperbolic)) {
            return *places;
        }
        let first: [fn(f64) -> f64; 2] = match hyperbolic {
            true => [f64::sinh, f64::cosh],
            false => [f64::sin, f64::cos],
        };
        let sign = if hyperbolic { 1.0 } else { -1.0 };
        let slope = self.slope(of);
        let place = self.emit(Operation::Waves {
            of,
            slope,
            degree: self.program.degree(slope),
            sign,
            first,
        });
        let places = [place, self.emit(Operation::SecondWave)];
        self.waves.insert((of, hyperbolic), places);
        places
    }

    /// Adds `y' = u' (1 + sign*y^2)`, the tangent or the hyperbolic tangent.
    fn tangent(&mut self, of: usize, sign: f64, first: fn(f64) -> f64) -> usize {
        let (one, sign) = (self.constant(1.0), self.constant(sign));
        let tangent = self.integral(of, 2, first);
        let square = self.emit(Operation::Multiply(tangent, tangent, usize::MAX));
        self.emit(Operation::Sum([(one, one), (sign, square)].into()));
        tangent
    }

    /// `1 + sign*u^2`.
    fn one_and_square(&mut self, of: usize, sign: f64) -> usize {
        let one = self.constant(1.0);
        let square = self.multiply(of, of);
        self.weighted(&[(1.0, one), (sign, square)])
    }

    /// Adds `y' = sign*u'/(1 + square*u^2)^(1/2)`, the inverse sine and cosine and the inverse
    /// hyperbolic sine.
    fn inverse_wave(
        &mut self,
        of: usize,
        [sign, square]: [f64; 2],
        first: fn(f64) -> f64,
    ) -> usize {
        let base = self.one_and_square(of, square);
        let root = self.emit(Operation::Power { base, exponent: 0.5, first: f64::powf });
        self.quotient(of, root, sign, first)
    }

    /// Adds the choice of one of two series by the sign of an argument, whose series is at `place`.
    fn choose(&mut self, argument: &Expr, place: usize, sides: [Option<usize>; 2]) -> usize {
        let guard = self.guards.find_or_add(argument);
        if guard.is_new {
            self.program.corners.push(place);
        }
        let [positive, negative] = match guard.is_aligned {
            true => sides,
            false => [sides[1], sides[0]],
        };
        self.emit(Operation::Choose { corner: guard.index, positive, negative })
    }

    /// Adds a function with a corner, from its arguments and the places of their series; `None` for
    /// any other function.
    fn corner(
        &mut self,
        function: Function,
        arguments: &[Expr],
        [u, v]: [usize; 2],
    ) -> Option<usize> {
        let [first, ..] = arguments else { return None };
        Some(match function {
            Function::Absolute => {
                let minus = self.scale(-1.0, u);
                self.choose(first, u, [Some(u), Some(minus)])
            }
            Function::Sign => {
                let (one, minus) = (self.constant(1.0), self.constant(-1.0));
                self.choose(first, u, [Some(one), Some(minus)])
            }
            Function::Step => {
                let one = self.constant(1.0);
                self.choose(first, u, [Some(one), None])
            }
            Function::Maximum | Function::Minimum => {
                let difference = self.weighted(&[(1.0, u), (-1.0, v)]);
                let sides = match function {
                    Function::Maximum => [Some(u), Some(v)],
                    _ => [Some(v), Some(u)],
                };
                self.choose(&(first - arguments.get(1)?), difference, sides)
            }
            _ => return None,
        })
    }

    fn function(&mut self, function: Function, u: usize) -> Result<usize, RecurrenceError> {
        Ok(match function {
            Function::Sin => self.waves(u, false)[0],
            Function::Cos => self.waves(u, false)[1],
            Function::Sinh => self.waves(u, true)[0],
            Function::Cosh => self.waves(u, true)[1],
            Function::Tan => self.tangent(u, 1.0, f64::tan),
            Function::Tanh => self.tangent(u, -1.0, f64::tanh),
            Function::Exp => self.exponential(u),
            Function::Log => self.quotient(u, u, 1.0, f64::ln),
            Function::Atan => {
                let over = self.one_and_square(u, 1.0);
                self.quotient(u, over, 1.0, f64::atan)
            }
            Function::Asin => self.inverse_wave(u, [1.0, -1.0], f64::asin),
            Function::Acos => self.inverse_wave(u, [-1.0, -1.0], f64::acos),
            Function::Asinh => self.inverse_wave(u, [1.0, 1.0], f64::asinh),
            special => return Err(RecurrenceError::Function(special.name())),
        })
    }
}

/// Returns the coefficients of `s^0` to `s^degree` of an expression with
/// `coordinate = centre + scale*s` and no other symbol; `None` if it is not analytic there,
/// contains another symbol, or a coefficient overflows.
///
/// ```
/// # use lindstedt_series as lindstedt;
/// use lindstedt::{expr::parse_expression, series::numeric_taylor};
/// let root = parse_expression("sqrt(x)").unwrap();
/// // sqrt(4 + 8 s) = 2 + 2 s - s^2 + ...
/// assert_eq!(numeric_taylor(&root, "x".into(), 4.0, 8.0, 2), Some(vec![2.0, 2.0, -1.0]));
/// assert_eq!(numeric_taylor(&root, "x".into(), 0.0, 1.0, 2), None);
/// ```
pub fn numeric_taylor(
    expr: &Expr,
    coordinate: Symbol,
    centre: f64,
    scale: f64,
    degree: usize,
) -> Option<Vec<f64>> {
    let mut recurrences = Recurrences::new(&[(coordinate, Some(1))], &BTreeMap::new(), degree);
    let place = recurrences.add(expr).ok()?;
    let mut tape = recurrences.into_tape();
    tape.set(0, 0, centre);
    if degree > 0 {
        tape.set(0, 1, scale);
    }
    // The expansion is repeated because the argument of one corner may depend on the side of
    // another.
    for _ in 0..=tape.corners().count() {
        tape.expand(&[]);
        if !tape.take_sides() {
            break;
        }
    }
    // On a corner itself there is no series.
    let series = tape.series(place);
    let analytic = tape.corners().all(|(argument, _)| argument[0] != 0.0);
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
            "asinh(2*x - 1)*x + asinh(x^2)",
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
        for text in ["abs(x)", "x^(1/3)", "log(x)", "1/x", "k*x", "x*H(log(x) + 3)", "max(x, 1/x)"]
        {
            let expression = parse_expression(text).expect(text);
            assert_eq!(numeric_taylor(&expression, x, 0.0, 1.0, 4), None, "{text}");
        }
        // Powers beyond the degree, where the base is zero.
        let high = parse_expression("x + x^10000").expect("powers");
        assert_eq!(numeric_taylor(&high, x, 0.0, 1.0, 2), Some(vec![0.0, 1.0, 0.0]));
    }

    /// A part that occurs twice is computed once, and sine and cosine come together.
    #[test]
    fn each_part_is_computed_once() {
        let count = |texts: &[&str]| {
            let mut recurrences = Recurrences::new(&[("x".into(), None)], &BTreeMap::new(), 1);
            for text in texts {
                recurrences.add(&parse_expression(text).expect(text)).expect(text);
            }
            recurrences.program.size()
        };
        assert_eq!(count(&["sin(x)"]), count(&["sin(x)", "cos(x)", "sin(x)"]));
        assert_eq!(count(&["sgn(x)*exp(x^2)", "exp(x^2)"]), count(&["sgn(x)*exp(x^2)"]));
    }
}

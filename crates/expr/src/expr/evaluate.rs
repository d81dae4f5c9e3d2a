//! Numerical evaluation of expressions.
//!
//! In comes an expression and values of its symbols, out goes an `f64`. [`Expr::evaluate`] is for a
//! single value, and fails if it is not finite; [`CompiledFunction`] is for integrators, which call
//! one expression millions of times.
//!
//! A product in which a factor built from `H` and `sgn` alone is zero is zero, whatever the other
//! factors are: `(x - xc)^(3/2)*H(x - xc)` is 0 on the near side of the barrier, where the power
//! has no real value.

mod prepared;
mod sampled;
mod specialised;

use std::collections::{BTreeMap, HashMap};

use num_integer::Integer as _;
use num_traits::{One, Signed, ToPrimitive};

use super::function::Value;
use super::{Expr, Function, Node};
use crate::exact::rational::{Integer, Rational, to_f64};
use crate::symbol::Symbol;

pub use prepared::PreparedList;
pub use sampled::SampledFunctions;

/// The reason why an expression has no number.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EvaluationError {
    /// A symbol has no value.
    #[error("`{0}` has no value here")]
    MissingSymbol(Symbol),
    /// The expression has no real or no finite value at this point.
    #[error("`{expression}` has no finite value at {point}")]
    Undefined {
        /// The expression, shortened.
        expression: String,
        /// The values of its symbols.
        point: String,
    },
}

impl Expr {
    /// The value at this point, rounded at each operation. Values of symbols that do not occur are
    /// ignored. The first evaluation compiles the expression; every further one costs as much as
    /// [`CompiledFunction::call`].
    ///
    /// # Errors
    /// A symbol has no value, or the result is not a finite number.
    pub fn evaluate(&self, values: &BTreeMap<Symbol, f64>) -> Result<f64, EvaluationError> {
        // Laws are evaluated at hundreds of amplitudes, one after the other.
        let (symbols, function) = self
            .0
            .compiled
            .get_or_init(|| {
                let symbols: Vec<Symbol> = self.symbols().into_iter().collect();
                let function = CompiledFunction::new(self, &symbols);
                Box::new((symbols, function))
            })
            .as_ref();
        let arguments = symbols
            .iter()
            .map(|symbol| {
                values.get(symbol).copied().ok_or(EvaluationError::MissingSymbol(*symbol))
            })
            .collect::<Result<Vec<f64>, _>>()?;
        let value = function.as_ref().map_err(EvaluationError::clone)?.call(&arguments);
        if value.is_finite() {
            return Ok(value);
        }
        let point: Vec<String> = symbols
            .iter()
            .zip(&arguments)
            .map(|(name, value)| format!("{name} = {value}"))
            .collect();
        Err(EvaluationError::Undefined {
            expression: super::print::in_message(self),
            point: if point.is_empty() { "any point".into() } else { point.join(", ") },
        })
    }
}

/// An expression as a list of floating-point operations, in which equal subexpressions are computed
/// once.
///
/// A call costs one operation per distinct node; small whole powers are multiplications and
/// `u^(3/2)` is `u*sqrt(u)`. Nothing is allocated unless the list has more than 64 values.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::{CompiledFunction, parse_expression};
/// let force = parse_expression("sin(x) + gamma*(x - xc)^1.5*H(x - xc)")?;
/// let force = CompiledFunction::new(&force, &["x".into(), "xc".into(), "gamma".into()])?;
/// assert_eq!(force.call(&[0.25, 1.0, 1e6]), 0.25_f64.sin());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct CompiledFunction(CompiledFunctions<1>);

/// Several expressions of the same arguments as one list of floating-point operations, in which
/// subexpressions that they have in common are computed once; each value is bit for bit that of its
/// [`CompiledFunction`].
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::{CompiledFunctions, parse_expression};
/// let [force, slope] = ["sin(x)^3", "3*sin(x)^2*cos(x)"].map(|text| parse_expression(text).expect("a text"));
/// let both = CompiledFunctions::new([&force, &slope], &["x".into()])?;
/// let sine = 0.25_f64.sin();
/// assert_eq!(both.call(&[0.25])[0], sine * sine * sine);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct CompiledFunctions<const N: usize> {
    list: InstructionList,
    results: [usize; N],
}

/// A number of expressions that is known at run time only, of the same arguments, as one list of
/// floating-point operations, as in [`CompiledFunctions`].
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::expr::{CompiledList, parse_expression};
/// let texts = ["x + y", "x*y", "3"];
/// let expressions = texts.map(|text| parse_expression(text).expect("a text"));
/// let all = CompiledList::new(&expressions, &["x".into(), "y".into()])?;
/// let mut values = [0.0; 3];
/// all.call(&[2.0, 5.0], &mut vec![], &mut values);
/// assert_eq!(values, [7.0, 10.0, 3.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct CompiledList {
    list: InstructionList,
    results: Vec<usize>,
}

/// The operations that compute all results.
#[derive(Clone, Debug)]
struct InstructionList {
    argument_count: usize,
    constants: Vec<f64>,
    instructions: Vec<Instruction>,
}

/// Operands are places in one row of values: arguments, constants, then the result of each
/// instruction in turn.
#[derive(Clone, Copy, Debug)]
enum Instruction {
    Add(usize, usize),
    Subtract(usize, usize),
    Multiply(usize, usize),
    Divide(usize, usize),
    /// Zero if the first is zero, otherwise the product.
    Gate(usize, usize),
    IntegerPower(usize, u32),
    SquareRoot(usize),
    /// The real root: base, exponent, and whether the result takes the sign of the base.
    OddRoot(usize, usize, bool),
    Power(usize, usize),
    Unary(fn(f64) -> f64, usize),
    Binary(fn(f64, f64) -> f64, usize, usize),
}

impl CompiledFunction {
    /// Translates the expression; `call` will take the values of these symbols in this order.
    ///
    /// # Errors
    /// A symbol of the expression is not among the arguments.
    pub fn new(expr: &Expr, arguments: &[Symbol]) -> Result<Self, EvaluationError> {
        CompiledFunctions::new([expr], arguments).map(Self)
    }

    /// The value at these arguments: NaN where the expression has no real value, infinite at a
    /// pole, and NaN if the number of arguments is not that of the symbols given to
    /// [`CompiledFunction::new`].
    pub fn call(&self, arguments: &[f64]) -> f64 {
        let [value] = self.0.call(arguments);
        value
    }
}

impl From<CompiledFunction> for CompiledFunctions<1> {
    fn from(CompiledFunction(functions): CompiledFunction) -> Self {
        functions
    }
}

impl<const N: usize> CompiledFunctions<N> {
    /// Translates the expressions; `call` will take the values of these symbols in this order.
    ///
    /// # Errors
    /// A symbol of an expression is not among the arguments.
    pub fn new(expressions: [&Expr; N], arguments: &[Symbol]) -> Result<Self, EvaluationError> {
        let mut places = [0; N];
        let (list, found) = InstructionList::new(expressions.into_iter(), arguments)?;
        places.copy_from_slice(&found);
        Ok(Self { list, results: places })
    }

    /// The values at these arguments, as those of [`CompiledFunction::call`].
    pub fn call(&self, arguments: &[f64]) -> [f64; N] {
        // Most forces are short: clearing more places than they need would take a fifth of a call.
        const SHORT: usize = 16;
        const LONG: usize = 64;
        let size = self.list.size();
        if arguments.len() != self.list.argument_count {
            return [f64::NAN; N];
        }
        if size <= SHORT {
            self.run(arguments, &mut [0.0; SHORT])
        } else if size <= LONG {
            self.run(arguments, &mut [0.0; LONG])
        } else {
            self.run(arguments, &mut vec![0.0; size])
        }
    }

    fn run(&self, arguments: &[f64], values: &mut [f64]) -> [f64; N] {
        self.list.run(arguments, values);
        self.results.map(|result| values[result])
    }
}

impl CompiledList {
    /// Translates the expressions; [`CompiledList::call`] will take the values of these symbols in
    /// this order.
    ///
    /// # Errors
    /// A symbol of an expression is not among the arguments.
    pub fn new(expressions: &[Expr], arguments: &[Symbol]) -> Result<Self, EvaluationError> {
        let (list, results) = InstructionList::new(expressions.iter(), arguments)?;
        Ok(Self { list, results })
    }

    /// Writes the values at these arguments into `values`; `scratch` is memory that calls share.
    /// The values are NaN if the number of arguments is not that of the symbols.
    pub fn call(&self, arguments: &[f64], scratch: &mut Vec<f64>, values: &mut [f64]) {
        if arguments.len() != self.list.argument_count {
            values.fill(f64::NAN);
            return;
        }
        scratch.resize(self.list.size(), 0.0);
        self.list.run(arguments, scratch);
        for (value, result) in values.iter_mut().zip(&self.results) {
            *value = scratch[*result];
        }
    }

    /// Writes the values as [`CompiledList::call`] does at the arguments in these lists, one after the other, in
    /// memory of its own: on the stack, unless the list is long.
    pub fn call_once(&self, arguments: &[&[f64]], values: &mut [f64]) {
        const SHORT: usize = 32;
        let count: usize = arguments.iter().map(|own| own.len()).sum();
        if self.list.size() > SHORT || count != self.list.argument_count {
            return self.call(&arguments.concat(), &mut vec![], values);
        }
        let mut scratch = [0.0; SHORT];
        let mut first = 0;
        for own in arguments.iter().chain([&self.list.constants.as_slice()]) {
            if !own.is_empty() {
                scratch[first..first + own.len()].copy_from_slice(own);
                first += own.len();
            }
        }
        self.list.run_instructions(&mut scratch);
        for (value, result) in values.iter_mut().zip(&self.results) {
            *value = scratch[*result];
        }
    }

    /// The list of some of the results, by their index, where the arguments from one on have these values,
    /// whatever a call gives them: what follows from them alone is computed once. Every value of a call is
    /// that of this list but for rounding, since a division by such a number becomes a product.
    ///
    /// ```
    /// # use lindstedt_expr as lindstedt;
    /// use lindstedt::expr::{CompiledList, parse_expression};
    /// let texts = ["exp(x)", "x/sqrt(k) + sin(k)"].map(|text| parse_expression(text).expect("a text"));
    /// let list = CompiledList::new(&texts, &["x".into(), "k".into()])?;
    /// let (mut both, mut second) = ([0.0; 2], [0.0]);
    /// list.call(&[3.0, 0.3], &mut vec![], &mut both);
    /// list.specialised(|index| index == 1, 1, &[0.3]).call(&[3.0, f64::NAN], &mut vec![], &mut second);
    /// assert!((both[1] - second[0]).abs() <= 2.0 * f64::EPSILON * both[1]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn specialised(
        &self,
        is_kept: impl Fn(usize) -> bool,
        first: usize,
        values: &[f64],
    ) -> Self {
        let kept = self.results.iter().enumerate().filter(|(index, _)| is_kept(*index));
        let kept: Vec<usize> = kept.map(|(_, place)| *place).collect();
        let (list, results) = self.list.specialised(&kept, first, values);
        Self { list, results }
    }
}

impl InstructionList {
    /// The operations for these expressions, and the places of their values.
    fn new<'a>(
        expressions: impl Iterator<Item = &'a Expr>,
        arguments: &[Symbol],
    ) -> Result<(Self, Vec<usize>), EvaluationError> {
        let mut compiler = Compiler {
            arguments,
            known: HashMap::new(),
            sizes: HashMap::new(),
            constants: Vec::new(),
            code: Vec::new(),
        };
        let compiled = expressions
            .map(|expr| expr.fold(|node, parts: &[ValueLocation]| compiler.node(node, parts)));
        let results: Vec<ValueLocation> = compiled.collect::<Result<_, _>>()?;
        Ok(compiler.finish(&results))
    }

    /// The number of places: arguments, constants and results of operations.
    fn size(&self) -> usize {
        self.argument_count + self.constants.len() + self.instructions.len()
    }

    /// Computes the result of every operation.
    fn run(&self, arguments: &[f64], values: &mut [f64]) {
        let constants_end = arguments.len() + self.constants.len();
        values[..arguments.len()].copy_from_slice(arguments);
        values[arguments.len()..constants_end].copy_from_slice(&self.constants);
        self.run_instructions(values);
    }

    /// Computes the result of every operation, behind the arguments and the constants.
    #[inline]
    fn run_instructions(&self, values: &mut [f64]) {
        let constants_end = self.argument_count + self.constants.len();
        for (offset, instruction) in self.instructions.iter().enumerate() {
            values[constants_end + offset] = instruction.value(values);
        }
    }
}

impl Instruction {
    /// The result where the operands have these values.
    #[inline(always)]
    fn value(&self, values: &[f64]) -> f64 {
        match *self {
            Self::Add(a, b) => values[a] + values[b],
            Self::Subtract(a, b) => values[a] - values[b],
            Self::Multiply(a, b) => values[a] * values[b],
            Self::Divide(a, b) => values[a] / values[b],
            Self::Gate(a, b) => gate(values[a], values[b]),
            Self::IntegerPower(a, exponent) => integer_power(values[a], exponent),
            Self::SquareRoot(a) => values[a].sqrt(),
            Self::OddRoot(a, b, odd) => odd_root(values[a], values[b], odd),
            Self::Power(a, exponent) => values[a].powf(values[exponent]),
            Self::Unary(function, a) => function(values[a]),
            Self::Binary(function, a, b) => function(values[a], values[b]),
        }
    }

    /// The places of both operands, twice the same of a single one.
    fn operands(&self) -> [usize; 2] {
        match *self {
            Self::Add(a, b)
            | Self::Subtract(a, b)
            | Self::Multiply(a, b)
            | Self::Divide(a, b)
            | Self::Gate(a, b)
            | Self::OddRoot(a, b, _)
            | Self::Power(a, b)
            | Self::Binary(_, a, b) => [a, b],
            Self::IntegerPower(a, _) | Self::SquareRoot(a) | Self::Unary(_, a) => [a, a],
        }
    }
}

/// Zero if the first is zero, otherwise the product.
fn gate(gate: f64, value: f64) -> f64 {
    if gate == 0.0 { 0.0 } else { gate * value }
}

/// The real root, with the sign of the base if the exponent is odd.
fn odd_root(base: f64, exponent: f64, odd: bool) -> f64 {
    let size = base.abs().powf(exponent);
    if odd && base < 0.0 { -size } else { size }
}

fn integer_power(base: f64, exponent: u32) -> f64 {
    let (mut result, mut square, mut left) = (1.0, base, exponent);
    while left > 1 {
        if left % 2 == 1 {
            result *= square;
        }
        square *= square;
        left /= 2;
    }
    result * square
}

/// The location of a value before the number of constants is known.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ValueLocation {
    Argument(usize),
    Constant(usize),
    Result(usize),
}

enum Operation {
    Pair(fn(usize, usize) -> Instruction, ValueLocation, ValueLocation),
    IntegerPower(ValueLocation, u32),
    SquareRoot(ValueLocation),
    OddRoot(ValueLocation, ValueLocation, bool),
    Unary(fn(f64) -> f64, ValueLocation),
    Binary(fn(f64, f64) -> f64, ValueLocation, ValueLocation),
}

struct Compiler<'a> {
    arguments: &'a [Symbol],
    /// Equal subexpressions share one slot.
    known: HashMap<Expr, ValueLocation>,
    /// The [sizes](Compiler::size) of all of them.
    sizes: HashMap<Expr, i64>,
    constants: Vec<f64>,
    code: Vec<Operation>,
}

impl Compiler<'_> {
    fn node(
        &mut self,
        expr: &Expr,
        children: &[ValueLocation],
    ) -> Result<ValueLocation, EvaluationError> {
        if let Some(slot) = self.known.get(expr) {
            return Ok(*slot);
        }
        let slot = match (expr.node(), children) {
            (Node::Number(value), _) => self.constant(to_f64(value)),
            (Node::Pi, _) => self.constant(std::f64::consts::PI),
            (Node::Symbol(symbol), _) => {
                let place = self.arguments.iter().position(|argument| argument == symbol);
                ValueLocation::Argument(place.ok_or(EvaluationError::MissingSymbol(*symbol))?)
            }
            (Node::Sum(terms), _) => self.sum(terms, children),
            (Node::Product(coefficient, factors), _) => {
                self.product(coefficient, factors, children)
            }
            (Node::Power(base, exponent), _)
                if self.shift(base, exponent.as_number()).is_some() =>
            {
                self.product(&Rational::one(), std::slice::from_ref(expr), children)
            }
            (Node::Power(_, exponent), [base, exponent_slot]) => match exponent.as_number() {
                Some(number) if number.is_negative() => {
                    let positive = self.power(*base, &-number);
                    let one = self.constant(1.0);
                    self.emit(Operation::Pair(Instruction::Divide, one, positive))
                }
                Some(number) => self.power(*base, number),
                None => self.emit(Operation::Pair(Instruction::Power, *base, *exponent_slot)),
            },
            (Node::Function(function, _), [first, ..]) => {
                self.function(*function, *first, children.get(1).copied().unwrap_or(*first))
            }
            (Node::Power(..) | Node::Function(..), _) => self.constant(f64::NAN),
        };
        self.known.insert(expr.clone(), slot);
        let size = self.size(expr);
        self.sizes.insert(expr.clone(), size);
        Ok(slot)
    }

    /// Returns the number of bits that the numbers in an expression contribute to its value,
    /// including the numbers in its sums.
    fn size(&self, expr: &Expr) -> i64 {
        let of = |part: &Expr| self.sizes.get(part).copied().unwrap_or(0);
        match expr.node() {
            Node::Number(number) => bits(number),
            Node::Product(coefficient, factors) => {
                let factors = factors.iter().map(of);
                factors.fold(bits(coefficient), i64::saturating_add)
            }
            Node::Sum(terms) => terms.iter().map(of).max().unwrap_or(0),
            Node::Power(base, exponent) => {
                let exponent = exponent.as_number().map_or(0.0, to_f64);
                (of(base) as f64 * exponent) as i64
            }
            _ => 0,
        }
    }

    /// Returns the shift of a sum whose numbers are so large that a product of a few of them, or
    /// the coefficient that compensates them, overflows; `None` for other bases and exponents.
    fn shift(&self, base: &Expr, exponent: Option<&Rational>) -> Option<Shift> {
        const LONG: u64 = 200;
        /// The longest number, in bits: no equation has larger ones, and they overflow whatever
        /// their factor.
        const LONGEST: u64 = 100_000;
        let size = match base.node() {
            Node::Sum(_) => u64::try_from(self.sizes.get(base).copied()?).ok()?,
            _ => return None,
        };
        let exponent = exponent?;
        let (numerator, denominator) = (exponent.numer().to_i32()?, exponent.denom().to_u32()?);
        if !(LONG..=LONGEST).contains(&size) {
            return None;
        }
        // The number of bits is a multiple of the denominator, so that the root of the divisor is a
        // power of two as well.
        let root_bits = size.div_ceil(u64::from(denominator));
        Some(Shift {
            bits: root_bits * u64::from(denominator),
            made_up: Rational::from_integer(Integer::one() << root_bits as usize).pow(numerator),
        })
    }

    fn sum(&mut self, terms: &[Expr], slots: &[ValueLocation]) -> ValueLocation {
        let mut total: Option<ValueLocation> = None;
        for (term, slot) in terms.iter().zip(slots) {
            total = Some(match total {
                None => *slot,
                Some(total) => match term.node() {
                    Node::Product(coefficient, factors) if (-coefficient).is_one() => {
                        // The product without its minus is compiled anew; its factors are known
                        // already.
                        let positive = self.positive_product(factors);
                        self.emit(Operation::Pair(Instruction::Subtract, total, positive))
                    }
                    _ => self.emit(Operation::Pair(Instruction::Add, total, *slot)),
                },
            });
        }
        total.unwrap_or_else(|| self.constant(0.0))
    }

    fn positive_product(&mut self, factors: &[Expr]) -> ValueLocation {
        let slots: Vec<ValueLocation> =
            factors.iter().filter_map(|factor| self.known.get(factor).copied()).collect();
        self.product(&Rational::one(), factors, &slots)
    }

    fn product(
        &mut self,
        coefficient: &Rational,
        factors: &[Expr],
        slots: &[ValueLocation],
    ) -> ValueLocation {
        let (mut above, mut below, mut gate): (
            Option<ValueLocation>,
            Option<ValueLocation>,
            Option<ValueLocation>,
        ) = (None, None, None);
        // Sums whose numbers would overflow enter divided by a power of two, for which the
        // coefficient compensates.
        let mut coefficient = coefficient.clone();
        let mut places: Vec<(ValueLocation, Option<ValueLocation>)> =
            Vec::with_capacity(slots.len());
        for (factor, slot) in factors.iter().zip(slots) {
            let (base, exponent) = match factor.node() {
                Node::Power(base, exponent) => (base, exponent.as_number().cloned()),
                _ => (factor, Some(Rational::one())),
            };
            places.push(match (self.shift(base, exponent.as_ref()), exponent) {
                (Some(shift), Some(exponent)) => {
                    let sum = self.scaled_sum(base, shift.bits);
                    coefficient *= shift.made_up;
                    let slot = match exponent.is_positive() {
                        true => self.power(sum, &exponent),
                        false => *slot,
                    };
                    (slot, Some(sum))
                }
                _ => (*slot, self.known.get(base).copied()),
            });
        }
        if !coefficient.is_one() {
            above = Some(self.constant(to_f64(&coefficient)));
        }
        for (factor, (slot, base)) in factors.iter().zip(&places) {
            match factor.node() {
                _ if is_gate(factor) => gate = Some(self.times(gate, *slot)),
                Node::Power(_, exponent) => {
                    let reciprocal = exponent.as_number().filter(|number| number.is_negative());
                    match (reciprocal, base) {
                        (Some(number), Some(base)) => {
                            let positive = self.power(*base, &-number);
                            below = Some(self.times(below, positive));
                        }
                        _ => above = Some(self.times(above, *slot)),
                    }
                }
                _ => above = Some(self.times(above, *slot)),
            }
        }
        let mut result = above;
        if let Some(below) = below {
            let above = above.unwrap_or_else(|| self.constant(1.0));
            result = Some(self.emit(Operation::Pair(Instruction::Divide, above, below)));
        }
        match (gate, result) {
            (Some(gate), Some(result)) => {
                self.emit(Operation::Pair(Instruction::Gate, gate, result))
            }
            (gate, result) => gate.or(result).unwrap_or_else(|| self.constant(1.0)),
        }
    }

    /// Compiles a sum divided by `2^bits`.
    fn scaled_sum(&mut self, sum: &Expr, bits: u64) -> ValueLocation {
        let unit = Rational::new(Integer::one(), Integer::one() << bits as usize);
        let mut total: Option<ValueLocation> = None;
        for term in sum.terms() {
            let (coefficient, factors) = term.factors();
            let slots: Vec<ValueLocation> =
                factors.iter().filter_map(|factor| self.known.get(factor).copied()).collect();
            let slot = self.product(&(coefficient * &unit), factors, &slots);
            total = Some(match total {
                None => slot,
                Some(total) => self.emit(Operation::Pair(Instruction::Add, total, slot)),
            });
        }
        total.unwrap_or_else(|| self.constant(0.0))
    }

    fn times(&mut self, product: Option<ValueLocation>, factor: ValueLocation) -> ValueLocation {
        match product {
            None => factor,
            Some(product) => self.emit(Operation::Pair(Instruction::Multiply, product, factor)),
        }
    }

    /// Compiles a power with a positive rational exponent.
    fn power(&mut self, base: ValueLocation, exponent: &Rational) -> ValueLocation {
        // Beyond this a chain of multiplications is no better than the library's power.
        const LARGEST_CHAIN: u32 = 64;
        let numerator = exponent.numer().to_u32().filter(|numerator| *numerator <= LARGEST_CHAIN);
        match (numerator, exponent.denom().to_u32()) {
            (Some(1), Some(1)) => base,
            (Some(numerator), Some(1)) => self.emit(Operation::IntegerPower(base, numerator)),
            (Some(1), Some(2)) => self.emit(Operation::SquareRoot(base)),
            (Some(numerator), Some(2)) => {
                let root = self.emit(Operation::SquareRoot(base));
                let whole = match numerator / 2 {
                    1 => base,
                    half => self.emit(Operation::IntegerPower(base, half)),
                };
                self.emit(Operation::Pair(Instruction::Multiply, whole, root))
            }
            (Some(1), Some(3)) => self.emit(Operation::Unary(f64::cbrt, base)),
            (_, Some(denominator)) if denominator > 1 && denominator.is_odd() => {
                let value = self.constant(to_f64(exponent));
                self.emit(Operation::OddRoot(base, value, exponent.numer().is_odd()))
            }
            _ => {
                let value = self.constant(to_f64(exponent));
                self.emit(Operation::Pair(Instruction::Power, base, value))
            }
        }
    }

    fn function(
        &mut self,
        function: Function,
        first: ValueLocation,
        second: ValueLocation,
    ) -> ValueLocation {
        match function.value_function() {
            Value::One(value) => self.emit(Operation::Unary(value, first)),
            Value::Two(value) => self.emit(Operation::Binary(value, first, second)),
        }
    }

    fn constant(&mut self, value: f64) -> ValueLocation {
        let place = self.constants.iter().position(|known| known.to_bits() == value.to_bits());
        ValueLocation::Constant(place.unwrap_or_else(|| {
            self.constants.push(value);
            self.constants.len() - 1
        }))
    }

    fn emit(&mut self, operation: Operation) -> ValueLocation {
        self.code.push(operation);
        ValueLocation::Result(self.code.len() - 1)
    }

    /// Removes unused constants and operations, such as reciprocals that became divisions, and
    /// numbers the others.
    fn finish(self, results: &[ValueLocation]) -> (InstructionList, Vec<usize>) {
        let mut constant_used = vec![false; self.constants.len()];
        let mut result_used = vec![false; self.code.len()];
        let mut mark = |slot: ValueLocation, results: &mut [bool]| match slot {
            ValueLocation::Argument(_) => {}
            ValueLocation::Constant(place) => constant_used[place] = true,
            ValueLocation::Result(place) => results[place] = true,
        };
        results.iter().for_each(|result| mark(*result, &mut result_used));
        for (place, operation) in self.code.iter().enumerate().rev() {
            if result_used[place] {
                for slot in operation.operands().into_iter().flatten() {
                    mark(slot, &mut result_used);
                }
            }
        }
        let argument_count = self.arguments.len();
        let (constant_places, constants_end) = number(&constant_used, argument_count);
        let (result_places, _) = number(&result_used, constants_end);
        let place = |slot: ValueLocation| match slot {
            ValueLocation::Argument(index) => index,
            ValueLocation::Constant(index) => constant_places[index],
            ValueLocation::Result(index) => result_places[index],
        };
        let instructions = kept(self.code, &result_used).map(|operation| operation.resolve(place));
        let list = InstructionList {
            argument_count,
            constants: kept(self.constants, &constant_used).collect(),
            instructions: instructions.collect(),
        };
        (list, results.iter().map(|result| place(*result)).collect())
    }
}

/// Returns the binary exponent of a number: the number of bits before the point, negative for a
/// small number.
fn bits(number: &Rational) -> i64 {
    number.numer().bits() as i64 - number.denom().bits() as i64 + 1
}

/// A scale that keeps a large sum within f64 when it is raised to a power, and its compensation.
struct Shift {
    /// The divisor is `2^bits`.
    bits: u64,
    /// The compensation `2^(bits*exponent)`.
    made_up: Rational,
}

/// A factor whose zero covers a whole interval, on which the other factors need no value.
fn is_gate(factor: &Expr) -> bool {
    factor.is_stepwise()
        && (factor.contains_function(Function::Step) || factor.contains_function(Function::Sign))
}

/// Returns consecutive places from `start` for the used entries, and the first place after them.
fn number(used: &[bool], start: usize) -> (Vec<usize>, usize) {
    let mut next = start;
    let places = used
        .iter()
        .map(|used| {
            let place = next;
            next += usize::from(*used);
            place
        })
        .collect();
    (places, next)
}

fn kept<T>(items: Vec<T>, used: &[bool]) -> impl Iterator<Item = T> {
    items.into_iter().zip(used).filter(|(_, used)| **used).map(|(item, _)| item)
}

impl Operation {
    fn operands(&self) -> [Option<ValueLocation>; 2] {
        match *self {
            Self::Pair(_, a, b) | Self::OddRoot(a, b, _) | Self::Binary(_, a, b) => {
                [Some(a), Some(b)]
            }
            Self::IntegerPower(a, _) | Self::SquareRoot(a) | Self::Unary(_, a) => [Some(a), None],
        }
    }

    fn resolve(self, place: impl Fn(ValueLocation) -> usize) -> Instruction {
        match self {
            Self::Pair(make, a, b) => make(place(a), place(b)),
            Self::IntegerPower(a, exponent) => Instruction::IntegerPower(place(a), exponent),
            Self::SquareRoot(a) => Instruction::SquareRoot(place(a)),
            Self::OddRoot(a, exponent, odd) => Instruction::OddRoot(place(a), place(exponent), odd),
            Self::Unary(function, a) => Instruction::Unary(function, place(a)),
            Self::Binary(function, a, b) => Instruction::Binary(function, place(a), place(b)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;

    fn at(text: &str, x: f64) -> Result<f64, EvaluationError> {
        parse_expression(text)
            .unwrap()
            .evaluate(&BTreeMap::from([(Symbol::new("x"), x), (Symbol::new("k"), 4.0)]))
    }

    #[test]
    fn values() {
        for (text, x, expected) in [
            ("x^3 - 2*x + 1", 3.0, 22.0),
            ("x^(1/3)", -8.0, -2.0),
            ("x^(2/3)", -8.0, 4.0),
            ("x^(-1/3)", -8.0, -0.5),
            ("x^(3/5)", -32.0, -8.0),
            ("x^1.5", 4.0, 8.0),
            ("x^(7/2)", 4.0, 128.0),
            ("x^(-5/2)", 4.0, 1.0 / 32.0),
            ("x^(5/4)", 16.0, 32.0),
            ("x^-3", -2.0, -0.125),
            ("x^65", -1.0, -1.0),
            ("x^0.5*k", 9.0, 12.0),
            ("k^x", 0.5, 2.0),
            ("sqrt(x^2)", -3.0, 3.0),
            ("2*pi", 0.0, std::f64::consts::TAU),
            ("k/x - x/k", 2.0, 1.5),
            ("1/(x*(1 + x))", 1.0, 0.5),
            ("x - k", 1.0, -3.0),
            ("1 - x*k - k*x^2", 1.0, -7.0),
            ("sgn(x) + H(x) + abs(x)", -2.0, 1.0),
            ("sgn(x) + H(x)", 0.0, 0.0),
            ("max(x, 1) + min(x, 1)", 3.0, 4.0),
            ("atan(x) - asin(x) + acos(x)", 0.0, std::f64::consts::FRAC_PI_2),
        ] {
            let value = at(text, x).unwrap();
            assert!(
                (value - expected).abs() <= 4.0 * f64::EPSILON * expected.abs(),
                "{text} at {x}: {value}"
            );
        }
    }

    /// On the near side of the barrier the contact force is exactly zero although its power has no
    /// value there.
    #[test]
    fn a_step_that_is_zero_wins() {
        for text in [
            "(x - 1)^1.5*H(x - 1)",
            "k*(x - 1)^1.5*H(x - 1)*log(x)",
            "sqrt(-x)*(1 - H(x))*H(x - 1)",
            "log(x)*(1 + sgn(x))",
            "H(x - 1)/sqrt(x)",
            "H(x)^2*sqrt(x)",
        ] {
            assert_eq!(at(text, -0.5), Ok(0.0), "{text}");
        }
        assert_eq!(at("(x - 1)^1.5*H(x - 1)", 5.0), Ok(8.0));
        // A factor that merely happens to be zero does not hide a pole.
        assert!(at("x/sin(x)", 0.0).is_err());
    }

    #[test]
    fn what_has_no_value_is_refused() {
        for (text, x) in
            [("sqrt(x)", -1.0), ("1/x", 0.0), ("log(x)", 0.0), ("x^x", -0.5), ("exp(x)", 1000.0)]
        {
            assert!(matches!(at(text, x), Err(EvaluationError::Undefined { .. })), "{text}");
        }
        assert_eq!(at("x + y", 1.0), Err(EvaluationError::MissingSymbol(Symbol::new("y"))));
        assert_eq!(
            at("sqrt(x)", -1.0).unwrap_err().to_string(),
            "`sqrt(x)` has no finite value at x = -1"
        );
        let x = parse_expression("x").unwrap();
        assert!(CompiledFunction::new(&x, &[]).is_err());
        assert!(CompiledFunction::new(&x, &["x".into()]).unwrap().call(&[]).is_nan());
    }

    #[test]
    fn equal_parts_are_computed_once_and_unused_ones_not_at_all() {
        let force = parse_expression("sin(x) + (gamma + mu*x')*(x - xc)^1.5*H(x - xc)").unwrap();
        let names: Vec<Symbol> = ["x", "x'", "xc", "gamma", "mu"].map(Symbol::new).to_vec();
        let compiled = CompiledFunction::new(&force, &names).unwrap();
        // sin, -xc, x - xc, its root, its power, mu*x', + gamma, *, H, gate, +
        assert!(compiled.0.list.instructions.len() <= 11, "{compiled:?}");
        let expected = 0.5_f64.sin() + (2.0 + 3.0 * 0.1) * 0.25_f64.powi(3);
        assert!((compiled.call(&[0.5, 0.1, 0.4375, 2.0, 3.0]) - expected).abs() < 1e-15);
        let quotient =
            CompiledFunction::new(&parse_expression("x/(x'*xc)").unwrap(), &names).unwrap();
        assert_eq!(quotient.0.list.instructions.len(), 2, "{quotient:?}");
    }

    #[test]
    fn powers_of_sums_with_numbers_beyond_doubles() {
        let (large, root) = (format!("1{}", "0".repeat(402)), format!("1{}", "0".repeat(201)));
        let sum = format!("({large} + {large}*x + x^2)");
        for (text, value) in [
            (format!("sqrt{sum}/{root}"), 2.0),
            (format!("{root}/sqrt{sum}"), 0.5),
            (format!("{sum}^(3/2)/{large}/{root}"), 8.0),
            (format!("{sum}^(1/3)/{large}^(1/3)"), 4.0_f64.cbrt()),
            (format!("{sum}^2/{large}^2"), 16.0),
            (format!("{root}*{root}*x/{sum}"), 0.75),
        ] {
            let found = at(&text, 3.0);
            let close = found.as_ref().is_ok_and(|found| (found / value - 1.0).abs() < 1e-14);
            assert!(close, "{found:?} for {value}");
        }
    }

    #[test]
    fn long_expressions_work_too() {
        let text: Vec<String> = (1..=200).map(|k| format!("x^{k}/{k}")).collect();
        let value = at(&text.join(" + "), 0.5).unwrap();
        assert!((value - std::f64::consts::LN_2).abs() < 1e-15);
    }
}

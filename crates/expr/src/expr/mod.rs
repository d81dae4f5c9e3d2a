//! Expressions, of which equations of motion and printed formulas consist.
//!
//! In come numbers, symbols and text; out goes an [`Expr`], an immutable tree that is cheap to
//! clone and always in *one normal form*, so that two expressions built in different ways compare
//! equal whenever the rules below can tell:
//!
//! - sums and products are flat and sorted; like terms and equal bases are merged:
//!   `2*x + 3*x = 5*x`, `x*x = x^2`;
//! - numbers are exact fractions and are folded wherever the result is one: `4^(1/2) = 2`,
//!   `sqrt(8) = 2*sqrt(2)`;
//! - `(a*b)^n = a^n*b^n` and `(u^a)^n = u^(a*n)` only for whole `n`: `(x^2)^(1/2)` is |x| and stays
//!   as it is;
//! - a number times a sum is distributed, and a sum that is a factor or a base has whole
//!   coefficients without common divisor, the first one positive: `z*(2 - 4*x) = 2*z*(1 - 2*x)`;
//!   products of sums wait for [`Expr::expand`];
//! - `u^(p/q)` with `q` odd is the real root: `(-8)^(1/3) = -2`;
//! - a point where the original is undefined may become defined (`x/x = 1`), never the other way
//!   round.
//!
//! An expression without a value (`1/0`, `log(0)`, `0^0`, `sqrt(-1)`) is an [`ExprError`], not a
//! silent infinity.
//!
//! ```
//! # use lindstedt_expr as lindstedt;
//! use lindstedt::expr::{Expr, parse_expression};
//! let force: Expr = parse_expression("2*zeta*x' + sin(x) - 0*k")?;
//! assert_eq!(force.to_string(), "2*zeta*x' + sin(x)");
//! assert_eq!(force.differentiate("x".into())?.to_string(), "cos(x)");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The parts: [`parse_expression`] and [`parse_equation`] read text, `Display` prints text that
//! reads back to the same tree, [`Expr::differentiate`] and [`Expr::substitute`] are the calculus,
//! [`Expr::evaluate`] and [`CompiledFunction`] give numbers. A new function such as `sech` is one
//! entry in the table of [`Function`].
//!
//! No walk over a tree recurses: each is a [`fold`](Expr::fold), so the depth of a tree costs
//! memory and not the stack.

mod calculus;
mod evaluate;
mod factor;
mod function;
mod jacobi;
mod normal;
mod number;
mod order;
mod overflow;
mod parse;
mod polynomial;
mod print;
mod rational_function;
mod rounding;
mod typed;

use std::collections::BTreeSet;
use std::collections::hash_map::DefaultHasher;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::sync::{Arc, LazyLock, OnceLock};

use num_traits::{One, Signed, Zero};
use rustc_hash::{FxHashMap, FxHashSet};

use crate::exact::rational::Rational;
use crate::symbol::Symbol;

pub use evaluate::{
    CompiledFunction, CompiledFunctions, CompiledList, EvaluationError, PreparedList,
    SampledFunctions,
};
pub use function::Function;
// Problem files show the place of an error in the same way.
pub use parse::excerpt;
pub use parse::{
    Assignments, Equation, NAMES_OF_ANSWERS, ParseError, equation_in_grammar,
    expression_in_grammar, parse_equation, parse_equations, parse_event, parse_expression,
    parse_inequality,
};
pub use print::Fraction;
pub use print::Inside;
pub use rounding::{LostDigits, Rounded};
pub use typed::{Quotation, Typed, excerpt_of};

pub use crate::symbol::letters::{InForce, ResultSymbols};
pub use crate::symbol::{fresh, fresh_stem, phase_beside};

/// The largest numerator or denominator of an exponent that [`Expr::power`] accepts on anything but
/// a number.
pub const LARGEST_EXPONENT: u32 = 10_000;

/// The number of products after which [`Expr::expand`] gives up.
pub const EXPANSION_LIMIT: usize = 100_000;

/// An immutable expression in normal form. A clone is one reference count.
#[derive(Clone)]
pub struct Expr(Arc<ExprData>);

/// One node of the tree. To read an expression, match on [`Expr::node`]; to build one, use [`Expr`]
/// only, which keeps the invariants stated on the variants.
#[derive(Clone)]
pub enum Node {
    /// An exact fraction.
    Number(Rational),
    /// The constant pi. A symbol of the name `pi` becomes this.
    Pi,
    /// A parameter, coordinate or derivative: `eps`, `x`, `x'`.
    Symbol(Symbol),
    /// A sum of at least two terms, none a sum or zero, at most one a number, no two alike up to a
    /// numeric factor; in the order in which they print.
    Sum(Vec<Expr>),
    /// A coefficient, not zero, and at least one factor (at least two where the coefficient is
    /// one). No factor is a number or a product, no two have the same base, a sum among them is
    /// primitive, and a single sum never stands beside a coefficient. In the order in which they
    /// print.
    Product(Rational, Vec<Expr>),
    /// Base and exponent. The exponent is neither 0 nor 1. A whole exponent stands on a symbol, pi,
    /// a function or a primitive sum; a number as base is a whole number above 1 to a power between
    /// 0 and 1, or to a symbolic power.
    Power(Expr, Expr),
    /// A function of the table with as many arguments as it takes.
    Function(Function, Vec<Expr>),
}

/// The reason why an expression could not be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ExprError {
    /// A quotient, or a negative power of zero.
    #[error("division by zero: `{0}`")]
    DivisionByZero(String),
    /// A value that no real number has: `0^0`, `log(0)`, `sqrt(-1)`.
    #[error("`{0}` has no real value")]
    Undefined(String),
    /// A number whose digits would fill the memory.
    #[error("`{0}` is too large a number to be written out")]
    NumberTooLarge(String),
    /// An exponent beyond [`LARGEST_EXPONENT`].
    #[error("the exponent in `{0}` is beyond {LARGEST_EXPONENT}")]
    ExponentTooLarge(String),
    /// A function called with the wrong number of arguments.
    #[error("`{function}` takes {expected} argument{}, not {given}", if *expected == 1 { "" } else { "s" })]
    WrongArguments {
        /// The function's name.
        function: &'static str,
        /// The number of arguments it takes.
        expected: usize,
        /// The number of arguments given.
        given: usize,
    },
    /// Writing the result out would take more products than allowed.
    #[error("stopped at {0} terms: the expression is too large to be written out")]
    TooManyTerms(usize),
}

impl Expr {
    /// The exact fraction as an expression.
    pub fn number(value: Rational) -> Self {
        Self::from_node(Node::Number(value))
    }

    /// The parameter or coordinate of this name, primes included; `pi` is the constant.
    pub fn symbol(name: &str) -> Self {
        Self::from(Symbol::new(name))
    }

    /// The constant pi.
    pub fn pi() -> Self {
        Self::from_node(Node::Pi)
    }

    /// The number 0.
    pub fn zero() -> Self {
        Self::number(Rational::zero())
    }

    /// The number 1.
    pub fn one() -> Self {
        static ONE: LazyLock<Expr> = LazyLock::new(|| Expr::number(Rational::one()));
        ONE.clone()
    }

    /// The sum of all terms in one go, in O(n log n). Adding them one by one costs O(n^2).
    pub fn sum(terms: impl IntoIterator<Item = Self>) -> Self {
        normal::sum(terms)
    }

    /// The product of all factors in one go, in O(n log n).
    pub fn product(factors: impl IntoIterator<Item = Self>) -> Self {
        normal::product(factors)
    }

    /// `base^exponent`; with an exponent `p/q`, `q` odd, the real root.
    ///
    /// # Errors
    /// Zero to a power that is not positive, an even root of a negative number, an exponent beyond
    /// [`LARGEST_EXPONENT`], or a number of more than a million bits.
    pub fn power(base: &Self, exponent: &Self) -> Result<Self, ExprError> {
        let result = normal::power(base, exponent)?;
        match normal::has_large_exponent(&result) {
            true => Err(ExprError::ExponentTooLarge(print::power_in_message(base, exponent))),
            false => Ok(result),
        }
    }

    /// `base^exponent` for a whole exponent.
    ///
    /// # Errors
    /// As for [`Expr::power`].
    pub fn integer_power(&self, exponent: i64) -> Result<Self, ExprError> {
        Self::power(self, &Self::from(exponent))
    }

    /// `numerator/denominator`.
    ///
    /// # Errors
    /// The denominator is zero.
    pub fn divide(numerator: &Self, denominator: &Self) -> Result<Self, ExprError> {
        if denominator.is_zero() {
            return Err(ExprError::DivisionByZero(format!("{}/0", print::in_message(numerator))));
        }
        Ok(numerator * normal::power(denominator, &Self::from(-1))?)
    }

    /// The function of these arguments, simplified where the table knows an exact value or a
    /// parity.
    ///
    /// # Errors
    /// The wrong number of arguments, or arguments at which the function has no value, as in
    /// `log(0)`.
    pub fn function(function: Function, arguments: Vec<Self>) -> Result<Self, ExprError> {
        function.apply(arguments)
    }

    /// The square root, which is the power 1/2.
    ///
    /// # Errors
    /// [`ExprError::Undefined`] for a negative number.
    pub fn sqrt(&self) -> Result<Self, ExprError> {
        Self::power(self, &Self::number(Rational::new(1.into(), 2.into())))
    }

    /// The sine, simplified where the argument allows it.
    pub fn sin(&self) -> Result<Self, ExprError> {
        Self::function(Function::Sin, vec![self.clone()])
    }

    /// The cosine, simplified where the argument allows it.
    pub fn cos(&self) -> Result<Self, ExprError> {
        Self::function(Function::Cos, vec![self.clone()])
    }

    /// Returns a node of this kind with other children, in the order of [`Expr::children`], in
    /// normal form. A leaf is returned as it is.
    ///
    /// # Errors
    /// The errors of [`Expr::power`] and [`Expr::function`].
    pub fn with_children(&self, children: &[Self]) -> Result<Self, ExprError> {
        match (self.node(), children) {
            (Node::Number(_) | Node::Pi | Node::Symbol(_), _) => Ok(self.clone()),
            (Node::Sum(_), _) => Ok(Self::sum(children.iter().cloned())),
            (Node::Product(coefficient, _), _) => {
                Ok(normal::scaled_product(coefficient.clone(), children))
            }
            (Node::Power(..), [base, exponent]) => Self::power(base, exponent),
            (Node::Power(..), _) => {
                Err(ExprError::WrongArguments { function: "^", expected: 2, given: children.len() })
            }
            (Node::Function(function, _), _) => Self::function(*function, children.to_vec()),
        }
    }

    /// The expression with every number in it changed, exponents included.
    ///
    /// # Errors
    /// As for [`Expr::with_children`].
    pub fn with_numbers(&self, change: &dyn Fn(&Rational) -> Rational) -> Result<Self, ExprError> {
        self.fold(|expr, children: &[Self]| match expr.node() {
            Node::Number(number) => Ok(Self::number(change(number))),
            Node::Product(coefficient, _) => {
                Ok(normal::scaled_product(change(coefficient), children))
            }
            _ => expr.with_children(children),
        })
    }

    /// The node itself, to match on.
    pub fn node(&self) -> &Node {
        &self.0.node
    }

    /// The expressions directly below: terms, factors, base and exponent, or arguments.
    pub fn children(&self) -> impl DoubleEndedIterator<Item = &Self> + Clone {
        self.node().children()
    }

    /// The value, if the expression is a number.
    pub fn as_number(&self) -> Option<&Rational> {
        match self.node() {
            Node::Number(value) => Some(value),
            _ => None,
        }
    }

    /// The symbol, if the expression is nothing else.
    pub fn as_symbol(&self) -> Option<Symbol> {
        match self.node() {
            Node::Symbol(symbol) => Some(*symbol),
            _ => None,
        }
    }

    /// Whether this is the number 0.
    pub fn is_zero(&self) -> bool {
        self.as_number().is_some_and(Zero::is_zero)
    }

    /// Whether this is the number 1.
    pub fn is_one(&self) -> bool {
        self.as_number().is_some_and(One::is_one)
    }

    /// The terms of a sum; anything else is its own only term.
    pub fn terms(&self) -> &[Self] {
        match self.node() {
            Node::Sum(terms) => terms,
            _ => std::slice::from_ref(self),
        }
    }

    /// The numeric coefficient and the other factors: `-x/6` gives -1/6 and `[x]`, a number itself
    /// and `[]`.
    pub fn factors(&self) -> (Rational, &[Self]) {
        match self.node() {
            Node::Number(value) => (value.clone(), &[]),
            Node::Product(coefficient, factors) => (coefficient.clone(), factors),
            _ => (Rational::one(), std::slice::from_ref(self)),
        }
    }

    /// Base and exponent; anything but a power is the base of the exponent 1.
    pub fn base_and_exponent(&self) -> (Self, Self) {
        match self.node() {
            Node::Power(base, exponent) => (base.clone(), exponent.clone()),
            _ => (self.clone(), Self::one()),
        }
    }

    /// Whether the expression prints with a minus in front, as `-x` and `-1 + x^2` do.
    pub fn has_leading_minus(&self) -> bool {
        match self.terms().first().map_or(self, |first| first).node() {
            Node::Number(value) | Node::Product(value, _) => value.is_negative(),
            _ => false,
        }
    }

    /// All symbols that occur.
    pub fn symbols(&self) -> BTreeSet<Symbol> {
        self.unique_nodes().filter_map(Self::as_symbol).collect()
    }

    /// Whether the symbol occurs.
    pub fn contains(&self, symbol: Symbol) -> bool {
        self.unique_nodes().any(|expr| expr.as_symbol() == Some(symbol))
    }

    /// Whether the function occurs.
    pub fn contains_function(&self, function: Function) -> bool {
        self.unique_nodes()
            .any(|expr| matches!(expr.node(), Node::Function(found, _) if *found == function))
    }

    /// Whether a function with a corner or a jump occurs: `abs`, `sgn`, `H`, `max` or `min`.
    pub fn contains_corner(&self) -> bool {
        self.unique_nodes()
            .any(|expr| matches!(expr.node(), Node::Function(found, _) if found.has_corner()))
    }

    /// Whether the expression has a value and all derivatives wherever its symbols have values: it is made of sums,
    /// products and whole positive powers, and of functions without a corner, a pole or an end of their domain.
    ///
    /// ```
    /// # use lindstedt_expr as lindstedt;
    /// use lindstedt::expr::Expr;
    ///
    /// assert!("x^3 - 2*sin(t)".parse::<Expr>()?.is_smooth_everywhere());
    /// assert!(!"x/(1 - x)".parse::<Expr>()?.is_smooth_everywhere());
    /// assert!(!"max(x, 0)".parse::<Expr>()?.is_smooth_everywhere());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn is_smooth_everywhere(&self) -> bool {
        use Function::{
            Asinh, Atan, BesselI0, BesselI1, BesselJ0, BesselJ1, Cos, Cosh, Exp, Sin, Sinh, Tanh,
        };
        self.unique_nodes().all(|expr| match expr.node() {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Sum(_) | Node::Product(..) => true,
            Node::Power(base, exponent) => match (base.node(), exponent.node()) {
                (Node::Number(_) | Node::Pi, _) => true,
                (_, Node::Number(exponent)) => exponent.is_integer() && exponent.is_positive(),
                _ => false,
            },
            Node::Function(function, _) => matches!(
                function,
                Sin | Cos
                    | Sinh
                    | Cosh
                    | Tanh
                    | Atan
                    | Asinh
                    | Exp
                    | BesselJ0
                    | BesselJ1
                    | BesselI0
                    | BesselI1
            ),
        })
    }

    /// Computes a value for the whole tree from the bottom up: `step` gets each node with the
    /// values of its children. The walk does not recurse, and visits a node that occurs in several
    /// places once.
    ///
    /// # Errors
    /// The first error of `step`.
    pub fn fold<T: Clone, E>(
        &self,
        mut step: impl FnMut(&Self, &[T]) -> Result<T, E>,
    ) -> Result<T, E> {
        let mut done: FxHashMap<*const ExprData, T> = FxHashMap::default();
        let mut open = vec![(self, false)];
        let mut values = Vec::new();
        while let Some((expr, children_done)) = open.pop() {
            if done.contains_key(&expr.address()) {
                continue;
            }
            if !children_done && expr.children().next().is_some() {
                open.push((expr, true));
                open.extend(expr.children().rev().map(|child| (child, false)));
                continue;
            }
            values.clear();
            values.extend(expr.children().filter_map(|child| done.get(&child.address()).cloned()));
            let value = step(expr, &values)?;
            if open.is_empty() {
                return Ok(value);
            }
            done.insert(expr.address(), value);
        }
        step(self, &values)
    }

    /// Returns every node, parents before children; a shared node comes once.
    pub fn unique_nodes(&self) -> impl Iterator<Item = &Self> {
        let mut seen = FxHashSet::default();
        let mut open = vec![self];
        std::iter::from_fn(move || {
            loop {
                let expr = open.pop()?;
                // A leaf is cheaper to repeat than to remember.
                if expr.children().next().is_none() || seen.insert(expr.address()) {
                    open.extend(expr.children().rev());
                    return Some(expr);
                }
            }
        })
    }

    fn address(&self) -> *const ExprData {
        Arc::as_ptr(&self.0)
    }

    /// Makes a node; the caller ensures the invariants of [`Node`]. No node is made anywhere else.
    fn from_node(node: Node) -> Self {
        let mut hasher = DefaultHasher::new();
        std::mem::discriminant(&node).hash(&mut hasher);
        let stepwise = match &node {
            Node::Number(value) => {
                // The hash of a fraction as a whole recurses along its continued fraction.
                (value.numer(), value.denom()).hash(&mut hasher);
                true
            }
            Node::Pi => true,
            Node::Symbol(symbol) => {
                symbol.hash(&mut hasher);
                false
            }
            Node::Sum(terms) => {
                terms.hash(&mut hasher);
                terms.iter().all(|term| term.0.stepwise)
            }
            Node::Product(coefficient, factors) => {
                (coefficient.numer(), coefficient.denom(), factors).hash(&mut hasher);
                factors.iter().all(|factor| factor.0.stepwise)
            }
            Node::Power(base, exponent) => {
                (base, exponent).hash(&mut hasher);
                base.0.stepwise && exponent.as_number().is_some_and(Signed::is_positive)
            }
            Node::Function(function, arguments) => {
                (function, arguments).hash(&mut hasher);
                matches!(function, Function::Step | Function::Sign)
            }
        };
        let size = node.children().fold(1, |size: u32, child| size.saturating_add(child.0.size));
        Self(Arc::new(ExprData {
            node,
            hash: hasher.finish(),
            size,
            stepwise,
            compiled: OnceLock::new(),
        }))
    }

    /// Whether the expression is constant between jumps: built only from numbers, `H` and `sgn`. A
    /// zero of such an expression extends over a whole interval.
    fn is_stepwise(&self) -> bool {
        self.0.stepwise
    }
}

impl Node {
    fn children(&self) -> impl DoubleEndedIterator<Item = &Expr> + Clone {
        let (list, pair): (&[Expr], _) = match self {
            Self::Number(_) | Self::Pi | Self::Symbol(_) => (&[], None),
            Self::Sum(list) | Self::Product(_, list) | Self::Function(_, list) => (list, None),
            Self::Power(base, exponent) => (&[], Some([base, exponent])),
        };
        list.iter().chain(pair.into_iter().flatten())
    }
}

struct ExprData {
    node: Node,
    /// The hash of the whole tree below, so that comparing and hashing need only one word.
    hash: u64,
    /// The number of nodes below, counting each occurrence; saturated at the largest `u32`.
    size: u32,
    stepwise: bool,
    /// The symbols and the compiled function, from the first evaluation on.
    compiled: OnceLock<Box<CompiledExpr>>,
}

/// The symbols of an expression, and its compiled function of their values.
type CompiledExpr = (Vec<Symbol>, Result<CompiledFunction, EvaluationError>);

/// Children are moved to a list instead of being dropped in place, so that a deep tree cannot
/// overflow the stack.
impl Drop for ExprData {
    fn drop(&mut self) {
        let mut open = Vec::new();
        let release = |node: &mut Node, open: &mut Vec<Expr>| match node {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => {}
            Node::Sum(children) | Node::Product(_, children) | Node::Function(_, children) => {
                open.append(children)
            }
            Node::Power(..) => {
                if let Node::Power(base, exponent) = std::mem::replace(node, Node::Pi) {
                    open.extend([base, exponent]);
                }
            }
        };
        release(&mut self.node, &mut open);
        while let Some(expr) = open.pop() {
            if let Some(mut inner) = Arc::into_inner(expr.0) {
                release(&mut inner.node, &mut open);
            }
        }
    }
}

impl PartialEq for Expr {
    fn eq(&self, other: &Self) -> bool {
        self.0.hash == other.0.hash && order::compare_structure(self, other).is_eq()
    }
}

impl Eq for Expr {}

impl Hash for Expr {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u64(self.0.hash);
    }
}

/// A total order of trees, for maps and sets. It is not the order of values, nor the order of
/// printing.
impl Ord for Expr {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        order::compare_structure(self, other)
    }
}

impl PartialOrd for Expr {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl fmt::Debug for Expr {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "`{self}`")
    }
}

impl From<Rational> for Expr {
    fn from(value: Rational) -> Self {
        Self::number(value)
    }
}

impl From<i64> for Expr {
    fn from(value: i64) -> Self {
        Self::number(Rational::from_integer(value.into()))
    }
}

impl From<Symbol> for Expr {
    fn from(symbol: Symbol) -> Self {
        match symbol.name() {
            "pi" => Self::pi(),
            _ => Self::from_node(Node::Symbol(symbol)),
        }
    }
}

impl std::str::FromStr for Expr {
    type Err = ParseError;

    /// Reads an expression as [`parse_expression`] does.
    fn from_str(text: &str) -> Result<Self, ParseError> {
        parse_expression(text)
    }
}

/// The operator on expressions and on references to them.
macro_rules! operator {
    ($trait:ident, $method:ident, |$left:ident, $right:ident| $result:expr) => {
        impl std::ops::$trait<&Expr> for &Expr {
            type Output = Expr;
            fn $method(self, other: &Expr) -> Expr {
                let ($left, $right) = (self, other);
                $result
            }
        }
        impl std::ops::$trait<Expr> for Expr {
            type Output = Expr;
            fn $method(self, other: Expr) -> Expr {
                std::ops::$trait::$method(&self, &other)
            }
        }
        impl std::ops::$trait<&Expr> for Expr {
            type Output = Expr;
            fn $method(self, other: &Expr) -> Expr {
                std::ops::$trait::$method(&self, other)
            }
        }
        impl std::ops::$trait<Expr> for &Expr {
            type Output = Expr;
            fn $method(self, other: Expr) -> Expr {
                std::ops::$trait::$method(self, &other)
            }
        }
    };
}

operator!(Add, add, |left, right| Expr::sum([left.clone(), right.clone()]));
operator!(Sub, sub, |left, right| Expr::sum([left.clone(), -right]));
operator!(Mul, mul, |left, right| Expr::product([left.clone(), right.clone()]));

impl std::ops::Neg for &Expr {
    type Output = Expr;
    fn neg(self) -> Expr {
        normal::scaled_product(-Rational::one(), std::slice::from_ref(self))
    }
}

impl std::ops::Neg for Expr {
    type Output = Expr;
    fn neg(self) -> Expr {
        -&self
    }
}

impl std::iter::Sum for Expr {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        Expr::sum(terms)
    }
}

impl std::iter::Product for Expr {
    fn product<I: Iterator<Item = Self>>(factors: I) -> Self {
        Expr::product(factors)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn pi_has_one_spelling() {
        assert_eq!(Expr::symbol("pi"), Expr::pi());
        assert_eq!(Expr::from(Symbol::new("pi")), Expr::pi());
        assert!(Expr::pi().symbols().is_empty());
    }

    #[test]
    fn equal_trees_are_equal_however_they_were_built() {
        let x = Expr::symbol("x");
        let square = &x * &x;
        assert_eq!(square, x.integer_power(2).unwrap());
        let mut set = std::collections::HashSet::from([square]);
        assert!(!set.insert(Expr::power(&x, &Expr::from(2)).unwrap()));
        assert_ne!(x, Expr::symbol("X"));
    }

    #[test]
    fn symbols_and_functions_are_found() {
        let force: Expr = "gamma*(x - xc)^1.5*H(x - xc) + 2*zeta*x'".parse().unwrap();
        let names: Vec<&str> = force.symbols().into_iter().map(Symbol::name).collect();
        assert_eq!(names, ["gamma", "x", "x'", "xc", "zeta"]);
        assert!(force.contains(Symbol::new("x'")) && !force.contains(Symbol::new("x''")));
        assert!(force.contains_function(Function::Step) && !force.contains_function(Function::Sin));
    }

    fn nested_cosines(depth: usize) -> Expr {
        (0..depth).fold(Expr::symbol("x"), |inner, _| inner.cos().unwrap())
    }

    #[test]
    fn a_tree_of_a_million_levels_is_compared_and_dropped() {
        let (first, second) = (nested_cosines(1_000_000), nested_cosines(1_000_000));
        assert_eq!(first, second);
        assert_eq!(first.symbols().len(), 1);
    }

    /// Deep enough to overflow the stack of a test thread at 20 bytes a level.
    #[test]
    fn depth_never_meets_the_stack() {
        let depth = 100_000;
        let expr = nested_cosines(depth);
        let x = Symbol::new("x");
        assert_eq!(expr.to_string().len(), 5 * depth + 1);
        assert_eq!(expr.expand().unwrap(), expr);
        assert_ne!(expr.substitute(x, &Expr::symbol("y")).unwrap(), expr);
        assert_eq!(expr.differentiate(x).unwrap_err(), ExprError::TooManyTerms(300_000));
        // cos repeated without end converges to the solution of cos(u) = u.
        let value = expr.evaluate(&BTreeMap::from([(x, 1.0)])).unwrap();
        assert!((value - value.cos()).abs() < 1e-15);
    }

    /// Through operators alone, which cannot fail: sums in products in sums, 100 000 levels.
    #[test]
    fn deep_sums_and_products_are_dropped_without_the_stack() {
        let (x, one) = (Expr::symbol("x"), Expr::one());
        let nested = (0..100_000).fold(x.clone(), |inner, _| &x * (&one + &x * inner));
        assert_eq!(nested.symbols().len(), 1);
    }

    /// A tree of 2^60 nodes of which 60 are different.
    #[test]
    fn shared_parts_are_visited_once() {
        let x = Symbol::new("x");
        let shared = (0..60).fold(Expr::from(x), |inner, _| {
            let sine = inner.sin().unwrap();
            Expr::function(Function::Maximum, vec![sine, inner]).unwrap()
        });
        assert_eq!(shared.symbols().len(), 1);
        let value = shared.evaluate(&BTreeMap::from([(x, -1.0)])).unwrap();
        assert!(value < 0.0 && value > -0.25, "{value}");
        assert!(shared.substitute(x, &Expr::zero()).unwrap().is_zero());
    }
}

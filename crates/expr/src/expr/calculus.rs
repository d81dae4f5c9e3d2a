//! Derivatives, substitution, and writing out products of sums.
//!
//! In comes an expression, out goes one in the same normal form, or an error. The rules are the
//! usual ones:
//!
//! ```text
//! (u*v)' = u'*v + u*v'        f(u, v)' = f_u*u' + f_v*v'
//! (u^n)' = n*u^(n-1)*u'       (u^v)'   = u^v*(v'*log(u) + v*u'/u)
//! ```
//!
//! with the partial derivatives f_u from the table of [`Function`]. `x`, `x'` and `x''` are
//! independent variables here.

use std::collections::BTreeMap;

use num_traits::ToPrimitive;

use super::{EXPANSION_LIMIT, Expr, ExprError, Function, Node, normal};
use crate::symbol::Symbol;

/// The number of factors after which a derivative gives up: the product rule squares the size of a
/// product.
const DERIVATIVE_LIMIT: usize = 300_000;

impl Expr {
    /// The partial derivative by the symbol. Jumps and kinks are left out: `sgn` and `H` have the
    /// derivative 0, `abs(u)` has `sgn(u)`, and `max(u, v)` has `H(u - v)` with respect to u.
    ///
    /// # Errors
    /// A factor of the derivative has no value, as in that of `(-2)^x`; or the product rule would
    /// write more than 300 000 factors.
    pub fn differentiate(&self, symbol: Symbol) -> Result<Self, ExprError> {
        let mut written = 0_usize;
        let mut count = |factors: usize| {
            written += factors;
            if written > DERIVATIVE_LIMIT {
                Err(ExprError::TooManyTerms(DERIVATIVE_LIMIT))
            } else {
                Ok(())
            }
        };
        self.fold(|expr, slopes: &[Self]| match expr.node() {
            Node::Number(_) | Node::Pi => Ok(Self::zero()),
            Node::Symbol(found) => Ok(Self::from(i64::from(*found == symbol))),
            Node::Sum(_) => {
                count(
                    slopes
                        .iter()
                        .filter(|slope| !slope.is_zero())
                        .map(|slope| slope.terms().len())
                        .sum(),
                )?;
                Ok(Self::sum(slopes.iter().cloned()))
            }
            Node::Product(coefficient, factors) => {
                let mut terms = Vec::new();
                for (index, slope) in
                    slopes.iter().enumerate().filter(|(_, slope)| !slope.is_zero())
                {
                    count(factors.len() + slope.factors().1.len())?;
                    let mut product = factors.clone();
                    product[index] = slope.clone();
                    terms.push(normal::scaled_product(coefficient.clone(), &product));
                }
                Ok(Self::sum(terms))
            }
            Node::Power(base, exponent) => match slopes {
                [base_slope, exponent_slope] => {
                    count(base_slope.factors().1.len() + exponent_slope.factors().1.len())?;
                    power_slope(expr, (base, base_slope), (exponent, exponent_slope))
                }
                _ => Ok(Self::zero()),
            },
            Node::Function(function, arguments) => {
                let mut terms = Vec::new();
                for (index, slope) in
                    slopes.iter().enumerate().filter(|(_, slope)| !slope.is_zero())
                {
                    count(1 + slope.factors().1.len())?;
                    terms.push(function.derivative(arguments, index)? * slope);
                }
                Ok(Self::sum(terms))
            }
        })
    }

    /// The expression with the value in place of the symbol. Derivatives of a coordinate are
    /// symbols of their own and stay.
    ///
    /// # Errors
    /// The result has no value: `1/x` at `x = 0`.
    pub fn substitute(&self, symbol: Symbol, value: &Self) -> Result<Self, ExprError> {
        self.substitute_all(&BTreeMap::from([(symbol, value.clone())]))
    }

    /// The expression with all these values substituted at once, so that `x` and `y` can be
    /// exchanged.
    ///
    /// # Errors
    /// As for [`Expr::substitute`].
    pub fn substitute_all(&self, values: &BTreeMap<Symbol, Self>) -> Result<Self, ExprError> {
        self.fold(|expr, children: &[Self]| {
            if let Some(value) = expr.as_symbol().and_then(|symbol| values.get(&symbol)) {
                return Ok(value.clone());
            }
            match expr.children().zip(children).all(|(old, new)| old.address() == new.address()) {
                true => Ok(expr.clone()),
                false => expr.with_children(children),
            }
        })
    }

    /// Expands products and whole powers of sums everywhere in the tree, with at most
    /// [`EXPANSION_LIMIT`] products.
    ///
    /// # Errors
    /// [`ExprError::TooManyTerms`] if that is not enough.
    pub fn expand(&self) -> Result<Self, ExprError> {
        self.expand_within(EXPANSION_LIMIT)
    }

    /// Expands as [`Expr::expand`], with at most `limit` products of two terms.
    ///
    /// # Errors
    /// [`ExprError::TooManyTerms`] if that is not enough.
    pub fn expand_within(&self, limit: usize) -> Result<Self, ExprError> {
        let mut budget = NodeBudget { left: limit, limit };
        let mut current = self.clone();
        loop {
            let next =
                current.fold(|expr, children: &[Self]| expand_node(expr, children, &mut budget))?;
            // Factors such as sqrt(1 + x)*sqrt(1 + x) make a new sum, so expansion is repeated
            // until nothing changes.
            if next == current {
                return Ok(next);
            }
            current = next;
        }
    }
}

fn power_slope(
    power: &Expr,
    (base, base_slope): (&Expr, &Expr),
    (exponent, exponent_slope): (&Expr, &Expr),
) -> Result<Expr, ExprError> {
    let lowered = || normal::power(base, &(exponent - Expr::one()));
    if exponent_slope.is_zero() {
        return match base_slope.is_zero() {
            true => Ok(Expr::zero()),
            false => Ok(Expr::product([exponent.clone(), lowered()?, base_slope.clone()])),
        };
    }
    let logarithm = Expr::function(Function::Log, vec![base.clone()])?;
    let mut result = Expr::product([power.clone(), exponent_slope.clone(), logarithm]);
    if !base_slope.is_zero() {
        result = result + Expr::product([exponent.clone(), lowered()?, base_slope.clone()]);
    }
    Ok(result)
}

struct NodeBudget {
    left: usize,
    limit: usize,
}

impl NodeBudget {
    fn spend(&mut self, amount: usize) -> Result<(), ExprError> {
        self.left = self.left.checked_sub(amount).ok_or(ExprError::TooManyTerms(self.limit))?;
        Ok(())
    }

    /// Fails if an operation that has not begun yet would exceed the budget.
    fn allow(&self, amount: usize) -> Result<(), ExprError> {
        match amount <= self.left {
            true => Ok(()),
            false => Err(ExprError::TooManyTerms(self.limit)),
        }
    }
}

/// Predicts the number of products of two terms in the power of a sum by repeated multiplication.
/// If every term but one has a symbol of its own, no two products of `m` of the `n` terms are
/// alike, and there are `C(m + n - 1, m)` of them. Returns zero if some products may be alike; the
/// count stops beyond `enough`.
fn products_of_power(terms: &[Expr], times: u32, enough: usize) -> usize {
    let mut shared = 0;
    for term in terms {
        let others = || terms.iter().filter(|other| *other != term);
        let own = term.factors().1.iter().any(|factor| {
            let (base, exponent) = factor.base_and_exponent();
            let symbol = base.as_symbol().filter(|_| exponent.as_number().is_some());
            symbol.is_some_and(|symbol| !others().any(|other| other.contains(symbol)))
        });
        shared += usize::from(!own);
    }
    if shared > 1 {
        return 0;
    }
    let (mut total, mut length) = (0_usize, 1_usize);
    for power in 0..times as usize {
        total = total.saturating_add(length.saturating_mul(terms.len()) - 1);
        if total > enough {
            break;
        }
        // C(m + n, m + 1) = C(m + n - 1, m) (m + n)/(m + 1).
        match length.checked_mul(power + terms.len()) {
            Some(product) => length = product / (power + 1),
            None => return usize::MAX,
        }
    }
    total
}

fn expand_node(expr: &Expr, children: &[Expr], budget: &mut NodeBudget) -> Result<Expr, ExprError> {
    match (expr.node(), children) {
        (Node::Product(coefficient, _), factors) => {
            factors.iter().try_fold(Expr::number(coefficient.clone()), |product, factor| {
                multiply(&product, factor, budget)
            })
        }
        (Node::Power(..), [base, exponent]) => {
            let times = exponent
                .as_number()
                .filter(|number| number.is_integer())
                .and_then(|number| number.to_integer().to_u32());
            match (base.node(), times) {
                (Node::Sum(terms), Some(times)) => {
                    budget.allow(products_of_power(terms, times, budget.left))?;
                    (0..times).try_fold(Expr::one(), |product, _| multiply(&product, base, budget))
                }
                _ => Expr::power(base, exponent),
            }
        }
        _ => expr.with_children(children),
    }
}

fn multiply(a: &Expr, b: &Expr, budget: &mut NodeBudget) -> Result<Expr, ExprError> {
    budget.spend(a.terms().len().saturating_mul(b.terms().len()).saturating_sub(1))?;
    let pairs =
        a.terms().iter().flat_map(|first| b.terms().iter().map(move |second| first * second));
    Ok(Expr::sum(pairs))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;

    /// The predicted number of products of a power is the number it takes.
    #[test]
    fn a_power_takes_the_products_that_are_foretold() {
        for (text, times, known) in [
            ("x + y", 1, true),
            ("1 + x", 9, true),
            ("1 + x + 2*y^3 - z*sin(1 + z)", 5, true),
            ("x*y + y + z", 4, true),
            ("x + x^2 + x^3", 6, false),
            ("x + y + x*y", 6, false),
        ] {
            let sum = parsed(text);
            let mut budget = NodeBudget { left: 10_000, limit: 10_000 };
            expand_node(
                &sum.integer_power(times).unwrap(),
                &[sum.clone(), Expr::from(times)],
                &mut budget,
            )
            .unwrap();
            let foretold = products_of_power(sum.terms(), times as u32, 10_000);
            match (known, times) {
                (true, 2..) => assert_eq!(foretold, 10_000 - budget.left, "{text}"),
                (true, _) => assert_eq!(foretold, sum.terms().len() - 1),
                (false, _) => assert_eq!(foretold, 0, "{text}"),
            }
        }
        for long in ["(x + y + z + 1)^60", "(1 + x)^10000"] {
            assert_eq!(parsed(long).expand(), Err(ExprError::TooManyTerms(EXPANSION_LIMIT)));
        }
    }

    fn parsed(text: &str) -> Expr {
        parse_expression(text).unwrap()
    }

    #[test]
    fn derivatives_by_x() {
        for (text, expected) in [
            ("k", "0"),
            ("x'", "0"),
            ("x^3/3", "x^2"),
            ("x*sin(x)", "sin(x) + x*cos(x)"),
            ("sin(2*x)^2", "4*sin(2*x)*cos(2*x)"),
            ("1/(1 + x^2)", "-2*x/(1 + x^2)^2"),
            ("sqrt(x)", "1/(2*sqrt(x))"),
            ("x^(1/3)", "1/(3*x^(2/3))"),
            ("tan(x)", "1 + tan(x)^2"),
            ("sinh(x) + cosh(x)", "sinh(x) + cosh(x)"),
            ("tanh(x)", "1/cosh(x)^2"),
            ("asin(x) + acos(x)", "0"),
            ("atan(x/k)", "1/(k*(1 + x^2/k^2))"),
            ("asinh(x/k)", "1/(k*sqrt(1 + x^2/k^2))"),
            ("exp(-k*x)", "-k*exp(-k*x)"),
            ("log(k*x)", "1/x"),
            ("abs(x)", "sgn(x)"),
            ("sgn(x) + H(x)", "0"),
            ("max(x, k)", "1 - H(k - x)"),
            ("min(x, k)", "H(k - x)"),
            ("(x - xc)^(3/2)*H(x - xc)", "3/2*sqrt(x - xc)*H(x - xc)"),
            ("k^x", "k^x*log(k)"),
            ("x^x", "x^x*log(x) + x*x^(x - 1)"),
            ("2^sqrt(2)", "0"),
        ] {
            assert_eq!(
                parsed(text).differentiate(Symbol::new("x")).unwrap(),
                parsed(expected),
                "{text}"
            );
        }
    }

    #[test]
    fn a_derivative_without_a_value_is_refused() {
        let x = Symbol::new("x");
        assert_eq!(
            parsed("(-2)^x").differentiate(x).unwrap_err(),
            ExprError::Undefined("log(-2)".into())
        );
        let wide =
            Expr::product((1..2_000).map(|k| (Expr::from(k) * Expr::from(x)).sin().unwrap()));
        assert_eq!(wide.differentiate(x).unwrap_err(), ExprError::TooManyTerms(DERIVATIVE_LIMIT));
    }

    #[test]
    fn substitution() {
        let x = Symbol::new("x");
        for (text, value, expected) in [
            ("x + x'", "y^2", "y^2 + x'"),
            ("sin(x)/x", "pi/2", "2/pi"),
            ("x^2 + 2*x + 1", "-1", "0"),
            ("sqrt(x^2)", "-3", "3"),
            ("x^(1/3)", "-8", "-2"),
            ("x*(1 + x)", "x + 1", "(1 + x)*(2 + x)"),
            ("(x - xc)^(3/2)*H(x - xc)", "xc", "0"),
        ] {
            assert_eq!(
                parsed(text).substitute(x, &parsed(value)).unwrap(),
                parsed(expected),
                "{text}"
            );
        }
        for text in ["1/x", "log(x)", "x^x", "y/sin(x)", "tan(pi/2 + x)"] {
            assert!(parsed(text).substitute(x, &Expr::zero()).is_err(), "{text}");
        }
        let swap = BTreeMap::from([(x, Expr::symbol("y")), (Symbol::new("y"), Expr::symbol("x"))]);
        assert_eq!(parsed("x - 2*y").substitute_all(&swap).unwrap(), parsed("y - 2*x"));
    }

    #[test]
    fn expansion() {
        for (text, expected) in [
            ("(x + 1)^3*(x - 1)", "x^4 + 2*x^3 - 2*x - 1"),
            ("(a + b)^2 - (a - b)^2", "4*a*b"),
            ("(1 + sqrt(1 + x))^2", "2 + x + 2*sqrt(1 + x)"),
            (
                "z*(1 + sqrt(1 + x))*(y + sqrt(1 + x))",
                "y*z + z + x*z + z*sqrt(1 + x) + y*z*sqrt(1 + x)",
            ),
            ("sin((x + 1)*x)", "sin(x + x^2)"),
            ("1/(x*(1 + x))", "1/(x*(1 + x))"),
            ("1/((1 + x)*(1 - x) + x^2)", "1"),
        ] {
            assert_eq!(parsed(text).expand().unwrap(), parsed(expected), "{text}");
        }
        assert!(parsed("1/((1 + x)*(1 - x) - 1 + x^2)").expand().is_err());
        let large = parsed("(x + y + z + 1)^60");
        assert_eq!(
            large.expand().unwrap_err().to_string(),
            "stopped at 100000 terms: the expression is too large to be written out"
        );
        assert_eq!(parsed("(x + 1)^3").expand_within(4).unwrap_err(), ExprError::TooManyTerms(4));
    }
}

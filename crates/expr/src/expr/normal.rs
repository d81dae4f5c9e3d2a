//! The normal form: the rules by which sums, products and powers are built.
//!
//! In come expressions that are each in normal form, out goes one; the rules are those listed in
//! [`super`]. Each rule examines only the nodes that it joins, so that the cost of building does
//! not depend on the size of the trees below.

use num_integer::Integer as _;
use num_traits::{One, Signed, ToPrimitive, Zero};

use super::{Expr, ExprError, LARGEST_EXPONENT, Node, number, order, print};
use crate::exact::rational::{self, Integer, Rational};

/// Returns the sum in normal form: flat, like terms merged, without zeros, sorted.
pub(super) fn sum(terms: impl IntoIterator<Item = Expr>) -> Expr {
    let mut constant = Rational::zero();
    let mut parts: Vec<LikeTerm> = Vec::new();
    for expr in terms {
        for term in expr.terms() {
            match term.node() {
                Node::Number(value) => constant = number::add(&constant, value),
                _ => parts.push(LikeTerm::from_term(term)),
            }
        }
    }
    merged(constant, parts)
}

/// Returns the sum of a number and of terms, not generic, so that it is compiled once.
fn merged(constant: Rational, mut parts: Vec<LikeTerm>) -> Expr {
    sort_by_hash(&mut parts, |part| &part.rest);
    let mut merged: Vec<Expr> = Vec::with_capacity(parts.len() + 1);
    if !constant.is_zero() {
        merged.push(Expr::number(constant));
    }
    for group in parts.chunk_by(|a, b| a.rest == b.rest) {
        if let [only] = group {
            merged.push(only.term.clone());
            continue;
        }
        let coefficient = group
            .iter()
            .fold(Rational::zero(), |total, part| number::add(&total, &part.coefficient));
        if let Some(part) = group.first()
            && !coefficient.is_zero()
        {
            merged.push(scaled(coefficient, part.rest.factors().1));
        }
    }
    match merged.len() {
        0 => Expr::zero(),
        1 => merged.swap_remove(0),
        _ => {
            order::sort_terms(&mut merged);
            Expr::from_node(Node::Sum(merged))
        }
    }
}

/// A term as a coefficient and the rest, which is the same for like terms.
struct LikeTerm {
    rest: Expr,
    coefficient: Rational,
    term: Expr,
}

impl LikeTerm {
    fn from_term(term: &Expr) -> Self {
        let (rest, coefficient) = match term.node() {
            Node::Product(coefficient, factors) if !coefficient.is_one() => {
                (scaled(Rational::one(), factors), coefficient.clone())
            }
            _ => (term.clone(), Rational::one()),
        };
        Self { rest, coefficient, term: term.clone() }
    }
}

/// Brings equal expressions together; the order itself means nothing.
fn sort_by_hash<T>(items: &mut [T], expr: impl Fn(&T) -> &Expr) {
    items.sort_by(|a, b| {
        let (a, b) = (expr(a), expr(b));
        a.0.hash.cmp(&b.0.hash).then_with(|| order::compare_structure(a, b))
    });
}

/// Returns the product in normal form: flat, numbers gathered in the coefficient, equal bases
/// merged, sorted.
pub(super) fn product(factors: impl IntoIterator<Item = Expr>) -> Expr {
    let mut gathered = ProductBuilder { coefficient: Rational::one(), powers: Vec::new() };
    for factor in factors {
        gathered.multiply(&factor);
    }
    gathered.finish()
}

/// `coefficient` times the product of the factors.
pub(super) fn scaled_product(coefficient: Rational, factors: &[Expr]) -> Expr {
    let mut gathered = ProductBuilder { coefficient, powers: Vec::new() };
    for factor in factors {
        gathered.multiply(factor);
    }
    gathered.finish()
}

/// A product in the making.
struct ProductBuilder {
    coefficient: Rational,
    powers: Vec<Factor>,
}

struct Factor {
    base: Expr,
    exponent: Expr,
    whole: Expr,
}

impl ProductBuilder {
    fn multiply(&mut self, factor: &Expr) {
        match factor.node() {
            Node::Number(value) => self.coefficient = number::multiply(&self.coefficient, value),
            Node::Product(coefficient, factors) => {
                self.coefficient = number::multiply(&self.coefficient, coefficient);
                factors.iter().for_each(|factor| self.push(factor.clone()));
            }
            Node::Sum(terms) => {
                let content = content(terms);
                self.push(divided(factor, &content));
                self.coefficient = number::multiply(&self.coefficient, &content);
            }
            _ => self.push(factor.clone()),
        }
    }

    fn push(&mut self, whole: Expr) {
        let (base, exponent) = whole.base_and_exponent();
        self.powers.push(Factor { base, exponent, whole });
    }

    fn finish(mut self) -> Expr {
        loop {
            if self.coefficient.is_zero() {
                return Expr::zero();
            }
            sort_by_hash(&mut self.powers, |factor| &factor.base);
            let powers = std::mem::take(&mut self.powers);
            let mut settled = true;
            for group in powers.chunk_by(|a, b| a.base == b.base) {
                match merge(group) {
                    Some(merged) => {
                        settled &= matches!(
                            merged.node(),
                            Node::Symbol(_) | Node::Pi | Node::Function(..)
                        ) || matches!(merged.node(), Node::Power(base, _) if *base == group[0].base)
                            || merged.as_number().is_some();
                        self.multiply(&merged);
                    }
                    None => group.iter().for_each(|factor| self.push(factor.whole.clone())),
                }
            }
            // A merged power may have split into factors whose bases occur elsewhere in the
            // product: merge again.
            if settled {
                break;
            }
        }
        let mut factors: Vec<Expr> = self.powers.into_iter().map(|factor| factor.whole).collect();
        factors.sort_by(order::compare_factors);
        scaled(self.coefficient, &factors)
    }
}

/// One power for factors of one base, or `None` if they stay as they are: a single factor, or a
/// power of a number that would be too long to write out.
fn merge(group: &[Factor]) -> Option<Expr> {
    match group {
        [] | [_] => None,
        [first, ..] => {
            power(&first.base, &sum(group.iter().map(|factor| factor.exponent.clone()))).ok()
        }
    }
}

/// Coefficient times factors that are merged and sorted already.
fn scaled(coefficient: Rational, factors: &[Expr]) -> Expr {
    match factors {
        _ if coefficient.is_zero() => Expr::zero(),
        [] => Expr::number(coefficient),
        [only] if coefficient.is_one() => only.clone(),
        [only] => match only.node() {
            // Multiplying every term by one number keeps them apart and in order.
            Node::Sum(terms) => Expr::from_node(Node::Sum(
                terms.iter().map(|term| rescaled(term, &coefficient)).collect(),
            )),
            _ => Expr::from_node(Node::Product(coefficient, factors.to_vec())),
        },
        _ => Expr::from_node(Node::Product(coefficient, factors.to_vec())),
    }
}

fn rescaled(term: &Expr, by: &Rational) -> Expr {
    let (coefficient, factors) = term.factors();
    scaled(number::multiply(&coefficient, by), factors)
}

/// The greatest number whose removal leaves whole coefficients without common divisor, with the
/// sign of the first.
fn content(terms: &[Expr]) -> Rational {
    let mut divisor = Integer::zero();
    let mut multiple = Integer::one();
    let mut negative = false;
    for (index, term) in terms.iter().enumerate() {
        let one = Rational::one();
        let coefficient = match term.node() {
            Node::Number(value) | Node::Product(value, _) => value,
            _ => &one,
        };
        negative |= index == 0 && coefficient.is_negative();
        divisor = number::greatest_common_divisor(&divisor, coefficient.numer());
        if !coefficient.denom().is_one() {
            let common = number::greatest_common_divisor(&multiple, coefficient.denom());
            multiple *= coefficient.denom() / common;
        }
    }
    // The fraction is in lowest terms: a divisor of every numerator divides no denominator.
    Rational::new_raw(if negative { -divisor } else { divisor }, multiple)
}

fn divided(sum: &Expr, content: &Rational) -> Expr {
    if content.is_one() { sum.clone() } else { scaled(content.recip(), std::slice::from_ref(sum)) }
}

/// The power without the limit on exponents, which products that merge bases must be free to pass.
pub(super) fn power(base: &Expr, exponent: &Expr) -> Result<Expr, ExprError> {
    let (mut base, mut exponent) = (base.clone(), exponent.clone());
    loop {
        let Some(number) = exponent.as_number().cloned() else {
            return symbolic_power(&base, &exponent);
        };
        if number.is_one() {
            return Ok(base);
        }
        if number.is_zero() {
            return match base.is_zero() {
                true => Err(ExprError::Undefined("0^0".into())),
                false => Ok(Expr::one()),
            };
        }
        let inner = match base.node() {
            Node::Number(value) => return number_power(value, &number),
            Node::Product(coefficient, factors) if number.is_integer() => {
                let coefficient = number_power(coefficient, &number)?;
                let powers: Result<Vec<Expr>, _> =
                    factors.iter().map(|factor| power(factor, &exponent)).collect();
                return Ok(product(powers?.into_iter().chain([coefficient])));
            }
            Node::Product(coefficient, _) => return root_of_scaled(&base, coefficient, &number),
            Node::Sum(terms) if number.is_integer() => {
                let content = content(terms);
                let primitive = Expr::from_node(Node::Power(divided(&base, &content), exponent));
                return Ok(product([number_power(&content, &number)?, primitive]));
            }
            Node::Sum(terms) => return root_of_scaled(&base, &content(terms), &number),
            Node::Power(inner, first)
                if number.is_integer() || inner.as_number().is_some_and(Signed::is_positive) =>
            {
                (inner.clone(), first * &exponent)
            }
            _ => return Ok(Expr::from_node(Node::Power(base, exponent))),
        };
        (base, exponent) = inner;
    }
}

/// Whether the expression is, or has as a factor, a power with a rational exponent beyond the
/// limit.
pub(super) fn has_large_exponent(expr: &Expr) -> bool {
    let limit = Integer::from(LARGEST_EXPONENT);
    expr.factors().1.iter().any(|factor| match factor.node() {
        Node::Power(_, exponent) => exponent
            .as_number()
            .is_some_and(|number| number.numer().abs() > limit || *number.denom() > limit),
        _ => false,
    })
}

fn symbolic_power(base: &Expr, exponent: &Expr) -> Result<Expr, ExprError> {
    if base.is_zero() {
        return Err(ExprError::Undefined(print::power_in_message(base, exponent)));
    }
    if base.is_one() {
        return Ok(Expr::one());
    }
    Ok(Expr::from_node(Node::Power(base.clone(), exponent.clone())))
}

/// Returns a fractional power of `base = factor * rest`: the part of the factor with an exact root
/// moves in front.
fn root_of_scaled(base: &Expr, factor: &Rational, exponent: &Rational) -> Result<Expr, ExprError> {
    let size = factor.abs();
    let sign = if factor.is_negative() { -Rational::one() } else { Rational::one() };
    let mut outside = Rational::one();
    let mut inside = Rational::one();
    for part in [sign, size] {
        match rational::power(&part, exponent) {
            Some(root) => outside *= root,
            None => inside *= part,
        }
    }
    let rest =
        scaled_product(number::multiply(&inside, &factor.recip()), std::slice::from_ref(base));
    let exponent = Expr::number(exponent.clone());
    Ok(match outside.is_one() {
        true => Expr::from_node(Node::Power(base.clone(), exponent)),
        false => product([Expr::number(outside), power(&rest, &exponent)?]),
    })
}

/// A number to an exact power: a number if there is one, otherwise a number times roots of whole
/// numbers.
fn number_power(base: &Rational, exponent: &Rational) -> Result<Expr, ExprError> {
    let message =
        || print::power_in_message(&Expr::number(base.clone()), &Expr::number(exponent.clone()));
    if base.is_zero() && !exponent.is_positive() {
        return Err(ExprError::DivisionByZero(message()));
    }
    if let Some(value) = rational::power(base, exponent) {
        return Ok(Expr::number(value));
    }
    let within =
        |integer: &Integer| integer.abs().to_u32().is_some_and(|size| size <= LARGEST_EXPONENT);
    if exponent.is_integer() || !within(&exponent.floor().to_integer()) {
        return Err(ExprError::NumberTooLarge(message()));
    }
    if !within(exponent.denom()) {
        return Err(ExprError::ExponentTooLarge(message()));
    }
    if base.is_negative() && exponent.denom().is_even() {
        return Err(ExprError::Undefined(message()));
    }
    // A negative base has an odd root here, and the sign comes back if the numerator is odd too.
    let negative = base.is_negative() && exponent.numer().is_odd();
    let mut coefficient = if negative { -Rational::one() } else { Rational::one() };
    let mut roots = Vec::new();
    for (part, exponent) in
        [(base.numer().abs(), exponent.clone()), (base.denom().clone(), -exponent)]
    {
        let (outside, root) =
            integer_root(part, exponent).ok_or_else(|| ExprError::NumberTooLarge(message()))?;
        coefficient *= outside;
        roots.extend(root);
    }
    Ok(product(roots.into_iter().chain([Expr::number(coefficient)])))
}

/// `base^exponent` of a whole number above zero as a number times a root `m^f`, `m` whole and 0 < f
/// < 1.
fn integer_root(base: Integer, exponent: Rational) -> Option<(Rational, Option<Expr>)> {
    /// The length in bits up to which roots are simplified: looking for divisors of longer numbers
    /// takes too long.
    const LONGEST: u64 = 4_096;
    let short = base.bits() <= LONGEST;
    let (base, exponent) = if short { as_perfect_power(base, exponent) } else { (base, exponent) };
    let whole = exponent.floor();
    let broken = &exponent - &whole;
    let mut outside = rational::power(&Rational::from_integer(base.clone()), &whole)?;
    if broken.is_zero() || base.is_one() {
        return Some((outside, None));
    }
    let mut inside = base.clone();
    // sqrt(12) = 2*sqrt(3): divisors below 100 are tried, which covers what people write.
    if let Some(degree) =
        broken.denom().to_u32().filter(|degree| short && u64::from(*degree) <= inside.bits())
    {
        for divisor in 2_u32..100 {
            let block = Integer::from(divisor).pow(degree);
            while inside.is_multiple_of(&block) {
                inside /= &block;
                outside *=
                    Rational::from_integer(Integer::from(divisor).pow(broken.numer().to_u32()?));
            }
        }
    }
    if inside != base {
        // The remaining number may be a perfect power: 72^(1/3) = 2*9^(1/3) = 2*3^(2/3).
        let (more, root) = integer_root(inside, broken)?;
        return Some((outside * more, root));
    }
    Some((
        outside,
        Some(Expr::from_node(Node::Power(Expr::number(inside.into()), Expr::number(broken)))),
    ))
}

/// Returns the power with the smallest base, `4^(1/3) = 2^(2/3)`, so that equal roots look equal.
fn as_perfect_power(base: Integer, exponent: Rational) -> (Integer, Rational) {
    /// The prime exponents that are tried.
    const PRIMES: [u32; 18] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61];
    let (mut base, mut exponent) = (Rational::from_integer(base), exponent);
    for degree in PRIMES {
        let fraction = Rational::new(1.into(), degree.into());
        while u64::from(degree) <= base.numer().bits() && !base.is_one() {
            let Some(root) = rational::power(&base, &fraction) else {
                break;
            };
            base = root;
            exponent *= Rational::from_integer(degree.into());
        }
    }
    (base.to_integer(), exponent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;

    #[test]
    fn one_normal_form() {
        for (text, expected) in [
            // Sums.
            ("2*x + 3*x", "5*x"),
            ("x - x", "0"),
            ("x + 0 + 1/2 - 1/2", "x"),
            ("x - (x + 1)", "-1"),
            ("(a + b) + (c - a)", "b + c"),
            ("x + x*y + x*y*z - x*z*y", "x + y*x"),
            ("x'' + sin(x) + 2*zeta*x'", "x'' + 2*zeta*x' + sin(x)"),
            ("sin(x) + x + 1", "1 + x + sin(x)"),
            ("7*A^4/1536 - A^2/8 + 1", "1 - A^2/8 + 7*A^4/1536"),
            ("xc + x", "x + xc"),
            // Products.
            ("x*x", "x^2"),
            ("x^a*x^b", "x^(a + b)"),
            ("x^a*x^(-a)", "1"),
            ("0*sin(x)", "0"),
            ("2*3*x/6", "x"),
            ("A^2*eps*3/4", "3*eps*A^2/4"),
            ("x'*zeta*2", "2*zeta*x'"),
            ("H(x - xc)*(x - xc)^(3/2)*gamma", "gamma*(x - xc)^(3/2)*H(x - xc)"),
            ("z*(2 - 4*x)", "2*z*(1 - 2*x)"),
            ("z*(x/2 - y/3)", "z*(3*x - 2*y)/6"),
            ("2*(1 - 2*x)", "2 - 4*x"),
            ("(1 + x)*(2 + 2*x)", "2*(1 + x)^2"),
            ("(x - 1)/(1 - x)", "-1"),
            ("sqrt(2*x + 2)*sqrt(2*x + 2)*(1 + x)*y", "2*y*(1 + x)^2"),
            ("sqrt(x*y)*sqrt(x*y)*x", "y*x^2"),
            // Powers.
            ("(p*q)^3", "p^3*q^3"),
            ("(x^(1/2))^4", "x^2"),
            ("(x^a)^3", "x^(3*a)"),
            ("(2*x)^-2", "1/(4*x^2)"),
            ("(2 - 4*x)^3", "8*(1 - 2*x)^3"),
            ("(4*x)^(1/2)", "2*sqrt(x)"),
            ("(2*x)^(1/2)", "sqrt(2*x)"),
            ("(4 + 8*x)^(1/2)", "2*sqrt(1 + 2*x)"),
            ("(xc - x)^(1/3)", "-(x - xc)^(1/3)"),
            ("(-x)^(1/2)", "sqrt(-x)"),
            ("x^1", "x"),
            ("x^0", "1"),
            ("1^x", "1"),
            // Roots of squares keep their sign, and no root is taken of a product.
            ("(x^2)^(1/2)", "sqrt(x^2)"),
            ("(x*y)^(1/2)", "sqrt(y*x)"),
            // Numbers.
            ("(-8)^(1/3)", "-2"),
            ("(-8)^(2/3)", "4"),
            ("(4/9)^(-3/2)", "27/8"),
            ("sqrt(8)", "2*sqrt(2)"),
            ("sqrt(1/2)", "sqrt(2)/2"),
            ("1/sqrt(2)", "sqrt(2)/2"),
            ("sqrt(2)*sqrt(2)", "2"),
            ("2^(1/2)*4^(1/3)", "2*2^(1/6)"),
            ("72^(1/3)", "2*3^(2/3)"),
            ("(-2)^(1/3)", "-2^(1/3)"),
            ("sqrt(sqrt(2))", "2^(1/4)"),
            ("2^x*2^(3 - x)", "8"),
            // Functions.
            ("sin(-x)", "-sin(x)"),
            ("cos(x - 1)", "cos(1 - x)"),
            ("sin(0) + cos(0) + exp(0) + log(1) + tan(0) + sinh(0) + cosh(0) + tanh(0)", "3"),
            ("sin(pi/2) + cos(-pi) + 4*atan(1) + 2*acos(0)", "2*pi"),
            ("asin(-1)", "-pi/2"),
            ("abs(-3/2) + sgn(-2) + H(0) + H(1) + max(1, 2) + min(1/2, 1/3)", "23/6"),
            ("max(x, y) - max(y, x)", "0"),
            ("max(x, x)", "x"),
        ] {
            let (built, direct) =
                (parse_expression(text).unwrap(), parse_expression(expected).unwrap());
            assert_eq!(built, direct, "{text}");
            assert_eq!(built.to_string(), expected, "{text}");
        }
    }

    #[test]
    fn different_values_stay_apart() {
        for (one, other) in [
            ("sqrt(x^2)", "x"),
            ("(x^4)^(1/4)", "x"),
            ("sqrt(x*y)", "sqrt(x)*sqrt(y)"),
            ("x^(2/3)", "x^(2/6)"),
            ("sqrt((1 - x)^2)", "1 - x"),
            ("abs(x)", "x"),
            ("H(x)", "H(-x)"),
            ("acos(-x)", "acos(x)"),
        ] {
            assert_ne!(parse_expression(one).unwrap(), parse_expression(other).unwrap(), "{one}");
        }
    }

    #[test]
    fn what_has_no_value_is_refused() {
        let power = |base: i64, numerator: i64, denominator: i64| {
            let exponent = Expr::number(Rational::new(numerator.into(), denominator.into()));
            Expr::power(&Expr::from(base), &exponent).unwrap_err()
        };
        assert_eq!(power(0, -1, 1), ExprError::DivisionByZero("0^(-1)".into()));
        assert_eq!(power(0, 0, 1), ExprError::Undefined("0^0".into()));
        assert_eq!(power(-1, 1, 2), ExprError::Undefined("(-1)^(1/2)".into()));
        assert_eq!(power(-2, 3, 4), ExprError::Undefined("(-2)^(3/4)".into()));
        assert_eq!(power(3, 1_000_000_000, 1), ExprError::NumberTooLarge("3^1000000000".into()));
        assert_eq!(
            power(3, 2_000_000_001, 2),
            ExprError::NumberTooLarge("3^(2000000001/2)".into())
        );
        let (x, zero) = (Expr::symbol("x"), Expr::zero());
        assert_eq!(Expr::divide(&x, &zero).unwrap_err(), ExprError::DivisionByZero("x/0".into()));
        assert_eq!(Expr::power(&zero, &x).unwrap_err(), ExprError::Undefined("0^x".into()));
        assert_eq!(
            x.integer_power(10_001).unwrap_err(),
            ExprError::ExponentTooLarge("x^10001".into())
        );
        assert_eq!(
            x.integer_power(-10_001).unwrap_err(),
            ExprError::ExponentTooLarge("x^(-10001)".into())
        );
        assert!(x.integer_power(10_000).is_ok());
    }

    /// Two powers of a number whose product could not be written out stand side by side.
    #[test]
    fn multiplication_never_fails() {
        let x = Expr::symbol("x");
        let two = |exponent: Expr| Expr::power(&Expr::from(2), &exponent).unwrap();
        let product = two(x.clone()) * two(Expr::from(2_000_000) - &x);
        assert_eq!(product.factors().1.len(), 2);
        let square = x.integer_power(9_999).unwrap() * x.integer_power(9_999).unwrap();
        assert_eq!(square.to_string(), "x^19998");
    }
}

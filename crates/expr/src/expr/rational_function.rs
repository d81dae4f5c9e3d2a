//! Rational functions of one letter and surds over them as expressions.

use num_traits::{One, Signed, Zero};

use super::{Expr, ExprError};
use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, QuadraticSurd, Rational, RationalFunction};
use crate::symbol::Symbol;

impl RationalFunction {
    /// The expression, numerator and denominator in factors.
    ///
    /// # Errors
    /// [`ExprError`], where an expression would be too long.
    ///
    /// ```
    /// # use lindstedt_expr as lindstedt;
    /// use lindstedt::exact::{Polynomial, RationalFunction, ratio};
    ///
    /// let mu = RationalFunction::from_polynomial(&Polynomial::symbol("mu".into()), "mu".into()).ok_or("mu")?;
    /// let one = RationalFunction::number(ratio(1, 1));
    /// let difference = one.sum(&mu).product(&one.sum(&mu)).difference(&one);
    /// let law = difference.quotient(&mu.product(&one.sum(&mu))).ok_or("a divisor")?;
    /// assert_eq!(law.to_expr("mu".into())?.to_string(), "(2 + mu)/(1 + mu)");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn to_expr(&self, letter: Symbol) -> Result<Expr, ExprError> {
        let (number, factors) = self.factors();
        let mut parts = vec![Expr::number(number)];
        for (factor, power) in factors {
            parts.push(written(&factor, letter).integer_power(power)?);
        }
        Ok(Expr::product(parts))
    }

    /// The expression of the square root, squares taken out; the letter is positive.
    ///
    /// # Errors
    /// [`ExprError`], as of the root of a negative number.
    pub fn sqrt_expr(&self, letter: Symbol) -> Result<Expr, ExprError> {
        let (outer, inner) = self.square_parts();
        Ok(outer.to_expr(letter)? * inner.to_expr(letter)?.sqrt()?)
    }
}

impl QuadraticSurd {
    /// The expression `factor*(a + b*sqrt(R))`; the letter is positive.
    ///
    /// # Errors
    /// [`ExprError`], where an expression would be too long.
    pub fn to_expr(&self, letter: Symbol) -> Result<Expr, ExprError> {
        match self.parts(letter)? {
            Some((factor, sum)) => Ok(factor.to_expr(letter)? * sum),
            None => Ok(Expr::zero()),
        }
    }

    /// The expression of the square root, squares taken out; the letter is positive.
    ///
    /// # Errors
    /// [`ExprError`], as of the root of a negative number.
    ///
    /// ```
    /// # use lindstedt_expr as lindstedt;
    /// use lindstedt::exact::{Polynomial, QuadraticSurd, RationalFunction, ratio};
    ///
    /// let mu = RationalFunction::from_polynomial(&Polynomial::symbol("mu".into()), "mu".into()).ok_or("mu")?;
    /// let [one, two] = [1, 2].map(|number| RationalFunction::number(ratio(number, 1)));
    /// let surd = QuadraticSurd::new(mu.clone(), &two, &one.sum(&mu));
    /// assert_eq!(surd.sqrt_expr("mu".into())?.to_string(), "sqrt(mu + 2*sqrt(1 + mu))");
    /// // 1 - sqrt(1 + mu) would lose its digits where mu is small.
    /// let surd = QuadraticSurd::new(one.clone(), &one.negative(), &one.sum(&mu));
    /// assert_eq!(surd.to_expr("mu".into())?.to_string(), "-mu/(1 + sqrt(1 + mu))");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sqrt_expr(&self, letter: Symbol) -> Result<Expr, ExprError> {
        let Some((factor, sum)) = self.parts(letter)? else { return Ok(Expr::zero()) };
        let (outer, inner) = factor.square_parts();
        let is_one_over = sum.base_and_exponent().1 == Expr::from(-1)
            && inner.numerator.as_slice() == [Rational::one()];
        let inside = inner.to_expr(letter)? * sum;
        // Rather 1/sqrt(a) than sqrt(1/a).
        let root = match is_one_over {
            true => inside.integer_power(-1)?.sqrt()?.integer_power(-1)?,
            false => inside.sqrt()?,
        };
        Ok(outer.to_expr(letter)? * root)
    }

    /// The common factor, and `a + b*sqrt(R)` as an expression. Where that is a difference which
    /// vanishes with the letter, it is one over the sum.
    fn parts(&self, letter: Symbol) -> Result<Option<(RationalFunction, Expr)>, ExprError> {
        let Some((factor, [rational, coefficient])) = self.common_factor() else {
            return Ok(None);
        };
        let lowest = |part: &RationalFunction| part.numerator.first().cloned();
        let signs = lowest(&rational).zip(lowest(&coefficient));
        let is_difference = signs.is_some_and(|(one, other)| (one * other).is_negative());
        let norm = rational
            .product(&rational)
            .difference(&coefficient.product(&coefficient).product(&self.radicand));
        let cancels = is_difference && norm.numerator.first().is_some_and(Zero::is_zero);
        let (factor, coefficient) = match cancels {
            true => (factor.product(&norm), coefficient.negative()),
            false => (factor, coefficient),
        };
        let root = self.radicand.sqrt_expr(letter)?;
        let times_root = match coefficient.is_zero() {
            true => Expr::zero(),
            false => coefficient.to_expr(letter)? * root,
        };
        let sum = written(&rational.numerator, letter) + times_root;
        Ok(Some(match cancels {
            true => (factor, sum.integer_power(-1)?),
            false => (factor, sum),
        }))
    }
}

/// A polynomial as an expression.
fn written(polynomial: &[Rational], letter: Symbol) -> Expr {
    let mut sum = Polynomial::zero();
    for (power, number) in polynomial.iter().enumerate() {
        let exponent = i32::try_from(power).unwrap_or(i32::MAX);
        sum.add_term(Monomial::power_of(letter, exponent), number.clone());
    }
    Expr::from(&sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::ratio;

    fn mu() -> RationalFunction {
        RationalFunction::from_polynomial(&Polynomial::symbol("mu".into()), "mu".into())
            .expect("a letter")
    }

    fn number(value: i64) -> RationalFunction {
        RationalFunction::number(ratio(value, 1))
    }

    #[test]
    fn squares_are_taken_out() {
        let shifted = number(1).sum(&mu());
        let square = number(2).sum(&mu()).quotient(&shifted.product(&shifted).scaled(&ratio(2, 1)));
        let root = square.expect("a divisor").sqrt_expr("mu".into()).expect("a root");
        assert_eq!(root.to_string(), "sqrt(1 + mu/2)/(1 + mu)");
    }
}

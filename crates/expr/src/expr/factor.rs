//! The common factor of all terms of a sum.
//!
//! ```text
//! 4 cos(B)/A^2 - 4 cos(A)/A^2 = 4 (cos(B) - cos(A))/A^2         1/u - A^2/u^2 = (u - A^2)/u^2   with a sum u, written out
//! ```

use num_traits::{Signed, Zero};

use super::Expr;
use crate::exact::Rational;

impl Expr {
    /// The sum with the powers common to all terms taken out in front; unchanged if there are none,
    /// or if the text would become longer.
    ///
    /// ```
    /// # use lindstedt_expr as lindstedt;
    /// use lindstedt::expr::Expr;
    /// let law: Expr = "4*A/3 - sqrt(2)*A/3".parse()?;
    /// assert_eq!(law.factored().to_string(), "A*(4 - sqrt(2))/3");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn factored(&self) -> Self {
        let shorter = |written: &Self| written.to_string().len() <= self.to_string().len();
        common_factor(self).filter(shorter).unwrap_or_else(|| self.clone())
    }
}

fn common_factor(sum: &Expr) -> Option<Expr> {
    /// Largest number of terms to which the factor of common powers of sums is expanded.
    const LONGEST: usize = 100;
    let (first, others) = sum.terms().split_first()?;
    if others.is_empty() {
        return None;
    }
    let powers = |term: &Expr| -> Vec<(Expr, Rational)> {
        let (_, factors) = term.factors();
        let powers = factors.iter().map(Expr::base_and_exponent);
        powers.filter_map(|(base, exponent)| Some((base, exponent.as_number()?.clone()))).collect()
    };
    let others: Vec<_> = others.iter().map(powers).collect();
    let common = powers(first).into_iter().filter_map(|(base, exponent)| {
        let exponents = others.iter().map(|powers| {
            let same = powers.iter().find(|(other, _)| *other == base)?;
            Some(same.1.clone())
        });
        let exponents = std::iter::once(Some(exponent)).chain(exponents);
        let exponents = exponents.collect::<Option<Vec<Rational>>>()?;
        let least = exponents.iter().min()?;
        let most = exponents.iter().max()?;
        let is_sum = base.terms().len() > 1;
        // In denominators a sum is taken out with its highest power; the lower ones are expanded in
        // the numerator.
        let shared = match (least.is_positive(), most.is_negative()) {
            (true, _) => least,
            (_, true) if is_sum && (least - most).is_integer() => least,
            (_, true) => most,
            _ => return None,
        };
        (!shared.is_zero()).then(|| Expr::power(&base, &Expr::number(shared.clone())).ok())?
    });
    let common = Expr::product(common);
    if common.is_one() {
        return None;
    }
    let parts = sum.terms().iter().map(|term| Expr::divide(term, &common));
    let rest = Expr::sum(parts.collect::<Result<Vec<_>, _>>().ok()?);
    Some(common * rest.expand_within(LONGEST).unwrap_or(rest))
}

#[cfg(test)]
mod tests {
    use crate::expr::Expr;

    #[test]
    fn what_is_common_stands_in_front() {
        for (text, factored) in [
            ("-4*cos(A)/A^2 + 4*cos(A/2)/A^2", "4*(cos(A/2) - cos(A))/A^2"),
            ("2/A^2 - 2/(A^2*sqrt(1 + A^2))", "2*(1 - 1/sqrt(1 + A^2))/A^2"),
            ("4/(4 + A^2) - 8*A^2/(4 + A^2)^2", "4*(4 - A^2)/(4 + A^2)^2"),
            ("2/sqrt(4 + A^2) - 2*A^2/(4 + A^2)^(3/2)", "8/(4 + A^2)^(3/2)"),
            ("k*A^2*sin(A) - k*A*cos(A)", "k*A*(A*sin(A) - cos(A))"),
            // Nothing to take out, or longer with it.
            ("1 + sqrt(A) - A^2/8", "1 + sqrt(A) - A^2/8"),
            ("1/A + A", "1/A + A"),
            ("sin(A)/A^2", "sin(A)/A^2"),
        ] {
            let expr: Expr = text.parse().expect(text);
            assert_eq!(expr.factored().to_string(), factored, "{text}");
            let difference =
                (&expr - &expr.factored()).evaluate(&[("A".into(), 0.7), ("k".into(), 1.3)].into());
            assert!(difference.expect(text).abs() < 1e-13, "{text}");
        }
    }
}

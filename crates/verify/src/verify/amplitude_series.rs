//! omega^2 of a conservative motion as a power series in its amplitude, from the integral of the
//! period.
//!
//! Reference: L. D. Landau and E. M. Lifshitz, *Mechanics*, 3rd ed., sections 11 and 12. In units
//! of the linear frequency, with `q(y) = 2 V(y)/y^2 = 1 + ...`, `w = y sqrt(q)` and its inverse
//! `y = g(w)`:
//!
//! ```text
//! T/(2 pi) = sum_(j even) g'_j (j-1)!!/j!! w(A)^j,      g'_j = [y^j] q^(-(j+1)/2)      (Lagrange's inversion)
//! omega^2  = (T/(2 pi))^(-2)
//! ```
//!
//! The inversion loses more digits than a double has, so the sums run in whole numbers over a large
//! power of two. The coefficients are then those of a force that differs from the given one by the
//! rounding of its Taylor coefficients.

use num_traits::{One, Zero};

use crate::exact::rational::{from_f64, to_f64};
use crate::exact::{Integer, Rational};

/// Bits behind the point.
const BITS: usize = 768;

/// The coefficients of `A^0, A^1, ...` of `omega^2/omega_0^2`, as many as the force has; `force[k]`
/// belongs to `y^k`, `force[1]` is one. `None` if a number is not finite.
pub(super) fn amplitude_series(force: &[f64]) -> Option<Vec<f64>> {
    let fixed = |value: f64| Some(to_integer(&from_f64(value)?));
    // 2 V/y^2: the coefficient of y^(k-1) is 2 f_k/(k+1).
    let potential: Vec<Integer> = force
        .iter()
        .enumerate()
        .skip(1)
        .map(|(k, &value)| Some(fixed(value)? * Integer::from(2) / Integer::from(k + 1)))
        .collect::<Option<_>>()?;
    let length = potential.len();
    let inverse_root = power(&potential, -1);
    let mut square = vec![Integer::zero(); length];
    for (n, value) in potential.iter().enumerate().take(length.saturating_sub(2)) {
        square[n + 2] = value.clone();
    }
    let mut one = vec![Integer::zero(); length];
    one[0] = Integer::one() << BITS;
    let (mut period, mut of_energy, mut of_inverse) =
        (vec![Integer::zero(); length], one, inverse_root.clone());
    let mut mean = Integer::one() << BITS;
    for j in (0..length).step_by(2) {
        let weight = (&of_inverse[j] * &mean) >> BITS;
        for (sum, value) in period.iter_mut().zip(&of_energy) {
            *sum += (&weight * value) >> BITS;
        }
        of_energy = multiply(&of_energy, &square);
        of_inverse = multiply(&multiply(&of_inverse, &inverse_root), &inverse_root);
        // The mean of cos^j grows by (j+1)/(j+2).
        mean = mean * Integer::from(j + 1) / Integer::from(j + 2);
    }
    let squared = power(&period, -4);
    let scale = Integer::one() << BITS;
    Some(squared.into_iter().map(|value| to_f64(&Rational::new(value, scale.clone()))).collect())
}

fn to_integer(value: &Rational) -> Integer {
    (value.numer() << BITS) / value.denom()
}

fn multiply(left: &[Integer], right: &[Integer]) -> Vec<Integer> {
    (0..left.len())
        .map(|n| {
            let terms = (0..=n).filter(|&k| !left[k].is_zero() && !right[n - k].is_zero());
            terms.map(|k| &left[k] * &right[n - k]).sum::<Integer>() >> BITS
        })
        .collect()
}

/// `u^(halves/2)` of a series that begins with one:
/// `n p_n = sum_(k=1..n) (a k - n + k) u_k p_(n-k)`.
fn power(u: &[Integer], halves: i64) -> Vec<Integer> {
    let mut p = vec![Integer::one() << BITS];
    for n in 1..u.len() {
        let weight = |k: usize| Integer::from(halves * k as i64 + 2 * k as i64 - 2 * n as i64);
        let term = |k: usize| &u[k] * &p[n - k] * weight(k);
        let sum: Integer = (1..=n).filter(|&k| !u[k].is_zero()).map(term).sum();
        p.push((sum >> BITS) / Integer::from(2 * n));
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::{Options, solve};
    use crate::oscillator::Oscillator;

    #[test]
    fn it_is_the_series_of_lindstedt_and_poincare() {
        let sine = |k: usize| match k % 4 {
            1 => 1.0 / (1..=k).map(|n| n as f64).product::<f64>(),
            3 => -1.0 / (1..=k).map(|n| n as f64).product::<f64>(),
            _ => 0.0,
        };
        let cases: [(&str, Vec<f64>); 3] = [
            ("x'' + sin(x) = 0", (0..=17).map(sine).collect()),
            (
                "x'' + x + x^2 = 0",
                (0..=17).map(|k| if k == 1 || k == 2 { 1.0 } else { 0.0 }).collect(),
            ),
            ("x'' + x + x^3/2 - x^4 = 0", {
                let mut force = vec![0.0; 18];
                (force[1], force[3], force[4]) = (1.0, 0.5, -1.0);
                force
            }),
        ];
        for (equation, force) in cases {
            let options =
                Options { order: Some(16), small: Some("A".to_owned()), ..Options::default() };
            let exact = solve(&Oscillator::parse(equation).unwrap(), &options).unwrap();
            let law = exact.law.frequency_squared().unwrap();
            let series = amplitude_series(&force).unwrap();
            for (power, found) in series.iter().enumerate() {
                let terms = law.terms();
                let exact: f64 = terms
                    .filter(|(monomial, _)| monomial.exponent("A".into()) == power as i32)
                    .map(|(_, number)| to_f64(number))
                    .sum();
                assert!(
                    (found - exact).abs() <= 1e-11 * exact.abs().max(1e-12),
                    "{equation} {power}: {found} {exact}"
                );
            }
        }
    }
}

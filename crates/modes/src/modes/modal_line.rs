//! Modal lines: every coordinate of a mode as a function of the first that moves.
//!
//! All coordinates are even in theta, and so polynomials in `c = cos theta`: the motion runs to and
//! fro on a line. With `x = a xi(c; a)`, `xi = c + a X_2(c) + ...`,
//!
//! ```text
//! y = sum_n a^n F_n(xi),    F_n = the part of  y - sum_(m<n) a^m F_m(xi)  at a^n, where xi = c
//! ```
//!
//! (R. M. Rosenberg, *J. Appl. Mech.* 29 (1962) 7.)

use num_traits::Zero;

use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{Polynomial, Polynomials};
use crate::series::FourierSeries;
use crate::symbol::Symbol;

/// Highest power of the amplitude and the coordinate together.
const HIGHEST: usize = 3;

/// A polynomial in c, lowest power first.
type InCosine = Vec<Polynomial>;

/// The coordinates of a mode as polynomials in the coordinate `of`, whose linear shape is one, and
/// the amplitude; `motion` has the orders of each coordinate from the first on.
pub(super) fn modal_lines(
    motion: &[Vec<FourierSeries<Polynomials>>],
    of: usize,
    name: Symbol,
    amplitude: Symbol,
) -> Vec<Polynomial> {
    let orders = motion.len().min(HIGHEST);
    let count = motion.first().map_or(0, Vec::len);
    let in_cosine = |coordinate: usize| -> Vec<InCosine> {
        motion[..orders].iter().map(|order| chebyshev(&order[coordinate])).collect()
    };
    // xi and its powers, by orders of the amplitude from zero on.
    let base = in_cosine(of);
    let mut powers: Vec<Vec<InCosine>> = vec![vec![vec![Polynomial::constant(ratio(1, 1))]]];
    for exponent in 1..=orders {
        let power = product(&powers[exponent - 1], &base, orders);
        powers.push(power);
    }
    let line = |coordinate: usize| {
        let mut rest = in_cosine(coordinate);
        let mut line = Polynomial::zero();
        for order in 0..orders {
            let leading = rest[order].clone();
            for (exponent, coefficient) in leading.iter().enumerate() {
                if coefficient.is_zero() {
                    continue;
                }
                let degree = i32::try_from(exponent).unwrap_or(i32::MAX);
                let below = i32::try_from(order + 1).unwrap_or(i32::MAX) - degree;
                let monomial =
                    Monomial::power_of(name, degree).product(&Monomial::power_of(amplitude, below));
                line.accumulate(&coefficient.times_monomial(&monomial));
                let Some(power) = powers.get(exponent) else { continue };
                for (later, part) in power.iter().enumerate() {
                    let Some(rest) = rest.get_mut(order + later) else { break };
                    subtract(rest, coefficient, part);
                }
            }
        }
        line
    };
    (0..count).map(line).collect()
}

/// A series of cosines as a polynomial in the cosine.
fn chebyshev(series: &FourierSeries<Polynomials>) -> InCosine {
    let highest = series.highest_harmonic();
    let mut sum = vec![Polynomial::zero(); highest + 1];
    let (mut last, mut current): (Vec<i64>, Vec<i64>) = (vec![1], vec![0, 1]);
    for harmonic in 0..=highest {
        let (coefficient, _) = series.cosine(harmonic).mean();
        for (power, factor) in last.iter().enumerate().filter(|(_, factor)| **factor != 0) {
            let factor = Polynomial::constant(ratio(*factor, 1));
            sum[power].accumulate(&coefficient.product(&factor));
        }
        // T_(k+1) = 2 c T_k - T_(k-1)
        let mut next = vec![0; current.len() + 1];
        for (power, factor) in current.iter().enumerate() {
            next[power + 1] += 2 * factor;
        }
        for (power, factor) in last.iter().enumerate() {
            next[power] -= factor;
        }
        last = std::mem::replace(&mut current, next);
    }
    sum
}

/// The product of two series in the amplitude, up to an order.
fn product(left: &[InCosine], right: &[InCosine], orders: usize) -> Vec<InCosine> {
    let mut found = vec![vec![]; orders];
    for (i, one) in left.iter().enumerate() {
        for (j, other) in right.iter().enumerate().take_while(|(j, _)| i + j < orders) {
            let sum: &mut InCosine = &mut found[i + j];
            for (m, a) in one.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
                for (n, b) in other.iter().enumerate().filter(|(_, b)| !b.is_zero()) {
                    if sum.len() <= m + n {
                        sum.resize(m + n + 1, Polynomial::zero());
                    }
                    sum[m + n].accumulate(&a.product(b));
                }
            }
        }
    }
    found
}

/// `rest - coefficient * part`.
fn subtract(rest: &mut InCosine, coefficient: &Polynomial, part: &InCosine) {
    if rest.len() < part.len() {
        rest.resize(part.len(), Polynomial::zero());
    }
    for (entry, other) in rest.iter_mut().zip(part) {
        let mut product = coefficient.product(other);
        product.negate();
        entry.accumulate(&product);
    }
}

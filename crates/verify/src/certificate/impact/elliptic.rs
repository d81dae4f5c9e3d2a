//! The incomplete elliptic integral of the first kind, enclosed.
//!
//! ```text
//! R_F(x, y, z) = 1/2 int_0^inf dt / sqrt((t + x)(t + y)(t + z))
//! R_F(x, y, z) = R_F((x + l)/4, (y + l)/4, (z + l)/4),   l = sqrt(x y) + sqrt(y z) + sqrt(z x)
//! max(x, y, z)^(-1/2) <= R_F(x, y, z) <= min(x, y, z)^(-1/2)
//! ```
//!
//! In: balls. Out: a ball that contains the integral of all numbers in them. Each step divides the
//! distances between the three arguments by four, so that half as many steps as there are binary
//! digits bring both bounds together.
//!
//! Source: B. C. Carlson: Numerical computation of real or complex elliptic integrals, Numerical
//! Algorithms 10 (1995), 13-26.

use crate::certificate::fourier_series::WORKING;
use crate::exact::ball::Ball;

/// `R_F` of numbers of which one, the first, may be zero; `None` if a ball reaches below zero.
pub(super) fn carlson_rf(x: &Ball, y: &Ball, z: &Ball) -> Option<Ball> {
    let root = |ball: &Ball| match ball.is_zero() {
        true => Some(Ball::zero()),
        false => WORKING.root(ball, 2),
    };
    let mut numbers = [x.clone(), y.clone(), z.clone()];
    for _ in 0..WORKING.bits.div_ceil(2) {
        let [a, b, c] = [root(&numbers[0])?, root(&numbers[1])?, root(&numbers[2])?];
        let products = [WORKING.product(&a, &b), WORKING.product(&b, &c), WORKING.product(&c, &a)];
        let shift = products.iter().fold(Ball::zero(), |sum, term| WORKING.sum(&sum, term));
        numbers = numbers.map(|number| WORKING.divided(&WORKING.sum(&number, &shift), 4));
    }
    let [x, mut y, z] = numbers;
    let apart = |other: &Ball| WORKING.magnitude(&WORKING.difference(other, &y));
    y.radius += apart(&x).max(apart(&z));
    WORKING.quotient(&WORKING.integer(1), &root(&y)?)
}

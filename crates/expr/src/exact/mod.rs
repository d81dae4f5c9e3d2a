//! Numbers that never round.
//!
//! In come whole numbers of any length, fractions and symbols; out go their sums, products and
//! quotients, exact, and their values as doubles where numbers are wanted. A division that a ring
//! cannot do is a [`NotInvertible`], which names the divisor.
//!
//! [`Rational`] is the coefficient that is printed; [`Polynomial`] carries the symbols; [`Ring`] is
//! what a derivation asks of its coefficients, so that one derivation serves exact numbers,
//! symbols, floating point, and rings that are chosen at run time. Where rounding cannot be
//! avoided, `BigFloat` rounds at any chosen precision, and a `Ball` contains every number that
//! rounding leaves possible; upper bounds of absolute values are `Bound`s, rounded up.

pub mod ball;
pub mod ball_products;
pub mod big_float;
pub mod bound;
pub mod complex_polynomial;
mod dense_product;
pub(crate) mod integer;
pub mod polynomial;
pub mod rational;
pub mod rational_function;
pub mod real_roots;
pub mod residue;
pub mod ring;
pub mod scaled;
pub mod zero_clusters;

pub use bound::Bound;
pub use complex_polynomial::ComplexPolynomial;
pub use integer::{Integer, ParseIntegerError};
pub use polynomial::{Monomial, POLYNOMIALS, Polynomial, Polynomials};
pub use rational::{Rational, convergent, factorial, from_f64, ratio, to_f64};
pub use rational_function::{QuadraticSurd, RationalFunction};
pub use ring::{Doubles, Integers, NotInvertible, Number, Rationals, Ring};
pub use scaled::Scaled;

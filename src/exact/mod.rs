//! Numbers that never round.
//!
//! [`Rational`] is the coefficient people see; [`Polynomial`] carries the symbols; [`Ring`] is what a derivation asks of its
//! coefficients, so that one derivation serves exact numbers, symbols, floating point, and rings that are chosen at run time.

pub mod polynomial;
pub mod rational;
pub mod real_roots;
pub mod ring;
pub mod scaled;

pub use polynomial::{POLYNOMIALS, Polynomial, Polynomials};
pub use rational::{Integer, Rational};
pub use ring::{Doubles, Integers, Number, Rationals, Ring};

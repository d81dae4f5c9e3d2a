//! Exact numbers, and expressions: the tree in which every formula and every equation is kept.
//!
//! In: text. Out: numbers exact to the last digit or with a proved bound, and a tree in one normal
//! form that prints, differentiates, substitutes and evaluates.
//!
//! Five names to know: [`exact::Rational`], a fraction of integers of any length; [`exact::Ring`],
//! the operations that a derivation needs of its coefficients; [`expr::Expr`], the tree, and
//! [`expr::parse_equation`], its parser; [`expr::CompiledFunction`], its evaluation in numbers.
//! Numbers and expressions share a crate because a polynomial prints as an expression.
//! [`parallel`], which runs pieces of work on all threads, is here because every piece needs the
//! letters of its answer.

#![warn(missing_docs)]

pub mod spelling;
pub mod symbol;

pub mod parallel;

pub mod exact;

pub mod decimal;

pub mod expr;

pub mod values;

pub use symbol::Symbol;
pub use values::{ValueError, Values};

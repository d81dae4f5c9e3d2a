//! Closed-form approximations of nonlinear vibrations, derived exactly and judged against the true motion.
//!
//! An equation of motion goes in as text; out come a frequency-amplitude law with exact coefficients, the motion as a
//! Fourier series in `theta = omega t`, and a verdict against the original equation:
//!
//! ```
//! use lindstedt::{Oscillator, method, verify};
//!
//! let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
//! let solution = method::solve(&pendulum, &method::Options { order: Some(2), ..Default::default() })?;
//! let law = solution.law.frequency_squared().expect("a polynomial law");
//! assert_eq!(law.to_string(), "1 - A^2/8");
//!
//! let mut at = verify::Values::default();
//! at.insert("A".into(), "1.5".parse()?)?;
//! let verdict = verify::judge(&pendulum, &solution, &at, 0.01)?;
//! assert_eq!(verdict.verdict, verify::Verdict::Fail); // 1.49 % off at 1.5 rad
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The modules stand in the order of the way of the data; each uses only those above it.
//!
//! | stage | module | what it holds |
//! | --- | --- | --- |
//! | below all | [`interrupt`] | a request to stop, which long work looks at |
//! | names and numbers | [`symbol`], [`spelling`], [`decimal`], [`exact`] | symbols, fractions, polynomials, the coefficient ring |
//! | expression | [`expr`] | the tree, its parser, printer, calculus and evaluation |
//! | series | [`series`] | Taylor, Fourier, running convolutions |
//! | any equations | [`system`] | first-order systems of any size by Taylor series and by Runge-Kutta, with events |
//! | answer and question | [`derivation`], [`solution`], [`oscillator`] | what a method returns and how it got there, and what it is given |
//! | numbers alone | [`ode`], [`period`], [`return_map`] | Runge-Kutta, quadrature, roots; the true period; limit cycles |
//! | forces of position alone | [`conservative`] | potential and projections in closed form |
//! | equilibrium | [`equilibrium`] | where the motion swings about |
//! | method | [`method`] | one file each |
//! | verify | [`verify`] | the true motion and the verdict |
//! | contact | [`contact`], [`impact`] | the three phases of a pendulum that hits an elastic barrier |
//! | damper | [`damper`] | the same pendulum with damping, friction, excitation and two barriers, event by event |
//! | in and out | [`catalog`], [`problem`], [`export`] | classical oscillators, problem files; text, LaTeX, JSON, pictures |

#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod interrupt;

pub mod symbol;

pub mod decimal;
pub mod exact;
pub mod spelling;

pub mod expr;
pub mod series;
pub mod system;

pub mod derivation;
pub mod solution;

pub mod oscillator;

pub mod conservative;

pub mod ode;
pub mod period;
pub mod return_map;

pub mod equilibrium;

pub mod method;
pub mod verify;

pub mod contact;
pub mod damper;
pub mod impact;

pub mod catalog;
pub mod problem;

pub mod export;

pub use oscillator::Oscillator;
pub use solution::Solution;
pub use symbol::Symbol;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;

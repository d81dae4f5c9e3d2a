//! Closed-form approximations of nonlinear vibrations, derived exactly and judged against the true
//! motion.
//!
//! An equation of motion goes in as text; out come a frequency-amplitude law with exact
//! coefficients, the motion as a Fourier series in `theta = omega t`, and a verdict against the
//! original equation:
//!
//! ```
//! use lindstedt::{Options, Oscillator, Verdict, judge, solve};
//!
//! let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
//! let solution = solve(&pendulum, &Options { order: Some(2), ..Options::default() })?;
//! assert_eq!(solution.formula(), "omega^2 = 1 - A^2/8");
//!
//! let at = "A = 3/2".parse()?;
//! let judged = judge(&pendulum, &solution, &at, 0.01)?;
//! assert_eq!(judged.verdict, Verdict::Fail); // 1.49 % off at 1.5 rad
//! println!("{}, at t = 1: {}", solution.motion_at(&at)?, solution.displacement_at(1.0, &at)?);
//! let document = lindstedt::export::json::solution(&solution, Some(&judged));
//! println!("{}", serde_json::to_string_pretty(&document)?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The modules stand in the order of the way of the data; each uses only those above it.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`numeric`] | true motions in numbers alone: Runge-Kutta, quadrature, roots; true periods; limit cycles in truth |
//! | [`genetic`] | search by a genetic algorithm, one file each operator; fronts of several values; what it is measured by |
//! | [`exact`] | fractions, polynomials, the coefficient ring |
//! | [`expr`] | the expression tree, its parser, printer, calculus and evaluation; names that are free |
//! | [`series`] | Taylor, Fourier, running convolutions |
//! | [`system`] | first-order systems of any size by Taylor series and by Runge-Kutta, with events |
//! | [`mechanics`] | energies to equations of motion, units, dimensionless groups, modes |
//! | [`solution`] | what a method returns: law, motion, notes, and how they were reached, line by line |
//! | [`oscillator`] | what a method is given |
//! | [`trajectory`] | any equation or mechanism followed in numbers, its energy accounted for |
//! | [`hill`] | linear equations with periodic coefficients: exact transition curves, Floquet's multipliers |
//! | [`method`] | one file each, one row in the table; potentials and projections in closed form |
//! | [`verify`] | the true motion and the verdict |
//! | [`certificate`] | a proof beside a formula: exactly one motion is so near, and the formula is off by so much |
//! | [`response`] | steady states of an oscillator: branches, stability, bifurcations, backbones |
//! | [`impact`] | a pendulum that hits an elastic barrier: three phases in closed form; all forces, event by event; sweeps |
//! | [`optimize`] | the design that rests soonest: genetic algorithm, constraints, fronts, what decides |
//! | [`problem`] | problem files |
//! | [`catalog`] | classical oscillators |
//! | [`audit`] | claims of publications, computed again, each with a verdict |
//! | [`report`] | what a report of a result says, for every format |
//! | [`export`] | text, LaTeX, JSON, programs, pictures, pages |
//!
//! | feature | what it adds |
//! | --- | --- |
//! | `cli` | the command-line program, with `json`, `toml`, `html` and `parallel` |
//! | `json` | documents, their readers and their schemas |
//! | `html` | pages that stand alone |
//! | `toml` | problem files |
//! | `parallel` | sweeps on all cores |
//! | `plot` | pictures in SVG |
//!
//! `cli` and `plot` are on unless default features are turned off.

#![warn(missing_docs)]

#[doc(inline)]
pub use lindstedt_dynamics::{mechanics, system};
#[doc(inline)]
pub use lindstedt_expr::{exact, expr};
#[doc(inline)]
pub use lindstedt_impact::{impact, optimize};
#[doc(inline)]
pub use lindstedt_numeric::{genetic, numeric};
#[doc(inline)]
pub use lindstedt_oscillator::{method, oscillator, solution};
#[doc(inline)]
pub use lindstedt_series::series;
#[doc(inline)]
pub use lindstedt_verify::{certificate, hill, response, trajectory, verify};

use lindstedt_expr::{decimal, spelling, symbol, values};
use lindstedt_numeric::interrupt;
use lindstedt_oscillator::derivation;

#[cfg(feature = "toml")]
pub mod problem;

pub mod catalog;

pub mod audit;

pub mod report;

pub mod export;

pub use interrupt::{Counter, Interrupt, Progress, Supervision};
pub use method::motion::Motion;
pub use method::numbers::NoNumbers;
pub use method::{Options, solve};
pub use oscillator::Oscillator;
pub use solution::{Method, Solution};
pub use symbol::Symbol;
pub use values::{ValueError, Values};
pub use verify::{Verdict, judge};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;

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
//! | module | what it does | first names |
//! | --- | --- | --- |
//! | [`method`] | derives a law, a motion, slow equations, by one method each | [`solve`], [`Options`] |
//! | [`oscillator`] | the equation that a method is given | [`Oscillator`] |
//! | [`solution`] | what a method returns: law, motion, notes, the derivation line by line | [`Solution`] |
//! | [`modes`] | derives the nonlinear normal modes of coupled equations | [`modes::derive`](modes::derive()) |
//! | [`multiple_scales`] | derives the slow equations of coupled equations | [`multiple_scales::derive`](multiple_scales::derive()) |
//! | [`absorber`] | derives the designs of vibration absorbers: tuned mass dampers, nonlinear sinks | [`absorber::derive`] |
//! | [`verify`] | judges a formula by the true motion, compares methods | [`judge`], [`verify::comparison::compare`] |
//! | [`certificate`] | proves how far a formula is from the true motion | [`certificate::certify`] |
//! | [`trajectory`] | follows any equation or mechanism in numbers: sections, sweeps, energies | [`trajectory::TrajectoryRequest`] |
//! | [`response`] | follows steady states through resonances: branches, stability, bifurcations | [`response::respond`] |
//! | [`absorber_verdict`] | judges absorbers by searches, branches and simulations | [`absorber_verdict::judge_absorber`] |
//! | [`shortest`] | searches the shortest frequency law within an error on a range, and proves it | [`shortest::search`] |
//! | [`fit`] | finds the law of a measured motion, with the errors of its parameters | [`fit::answer::fit`] |
//! | [`hill`] | says where rest is stable under periodic coefficients: transition curves, multipliers | [`hill::transition_curves`] |
//! | [`coupled`] | reads coupled equations of motion of any number of coordinates | [`coupled::CoupledEquations`] |
//! | [`wall`] | reads rigid walls with a coefficient of restitution | [`wall::Wall`] |
//! | [`contact`] | writes walls that give way as forces in the equations | [`contact::CompliantContact`] |
//! | [`mechanics`] | makes equations of motion from energies; units, dimensionless groups, modes | [`mechanics::Mechanism`] |
//! | [`impact`] | a pendulum that hits an elastic barrier: three phases in closed form, or event by event | [`impact::solve`], [`impact::simulate`](impact::simulate()) |
//! | [`optimize`] | searches the damper that rests soonest: constraints, fronts, what decides | [`optimize::optimize`](optimize::optimize()) |
//! | [`orbits`] | periodic motions between rigid walls: speeds, multipliers, charts | [`orbits::laws`], [`orbits::find_orbits`] |
//! | [`audit`] | computes the claims of publications again | [`audit::audit`](audit::audit()) |
//! | [`problem`] | reads problem files | [`problem::Problem`] |
//! | [`catalog`] | classical oscillators by name | [`catalog::find`] |
//! | [`report`] | what a report of a result says, for every format | [`report::Document`] |
//! | [`cli`] | the program, and its commands inside another process | [`cli::run`], [`cli::call`] |
//! | [`export`] | text, LaTeX, JSON, programs, pictures, pages | [`export::latex`], [`export::code`] |
//! | [`expr`] | the expression tree: reading, printing, calculus, evaluation | [`expr::Expr`] |
//! | [`exact`] | fractions, polynomials, rings of coefficients | [`exact::Ring`] |
//! | [`series`] | Taylor and Fourier series, running convolutions | [`series::FourierSeries`] |
//! | [`system`] | first-order systems by Taylor series and Runge-Kutta, with events | [`system::System`] |
//! | [`numeric`] | Runge-Kutta, quadrature, roots, harmonic balance, periodic orbits | [`numeric::ode`] |
//! | [`genetic`] | a genetic algorithm, one file an operator | [`genetic::search`] |
//!
//! Six programs to begin with are in `examples/`: `first_law`, `which_method`, `resonance_curve`,
//! `poincare_section`, `impact_phases`, `coupled_modes`.
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
pub use lindstedt_dynamics::{contact, coupled, mechanics, system, wall};
#[doc(inline)]
pub use lindstedt_expr::{exact, expr};
#[doc(inline)]
pub use lindstedt_fit::fit;
#[doc(inline)]
pub use lindstedt_impact::{impact, optimize, orbits};
#[doc(inline)]
pub use lindstedt_modes::{absorber, modes, multiple_scales};
#[doc(inline)]
pub use lindstedt_numeric::{genetic, numeric};
#[doc(inline)]
pub use lindstedt_oscillator::{method, oscillator, solution};
#[doc(inline)]
pub use lindstedt_series::series;
#[doc(inline)]
pub use lindstedt_verify::{absorber_verdict, certificate, hill, response};
#[doc(inline)]
pub use lindstedt_verify::{shortest, trajectory, verify};

use lindstedt_expr::{decimal, spelling, symbol, values};
use lindstedt_numeric::interrupt;
use lindstedt_oscillator::derivation;

#[cfg(feature = "toml")]
pub mod problem;

pub mod catalog;

pub mod audit;

pub mod report;

pub mod export;

#[cfg(feature = "cli")]
pub mod cli;

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

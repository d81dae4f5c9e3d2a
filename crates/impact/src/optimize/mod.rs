//! The best damper: a genetic search for the design that rests soonest, and what decides it.
//!
//! In: an [`OptimizationProblem`]: what may vary between which limits, what is held fixed, what is
//! to be small, how it is searched. Out: a [`Study`]: the best design judged again by integration,
//! how far many runs agree, what the same number of evaluations finds otherwise, the default design
//! under the same assumptions, and why the best one is best: a [`Decision`]. With several
//! objectives at once it is the Pareto front.
//!
//! - `objective`: what may be small or limited, one row each.
//! - `question`: the box, the constraints, the options.
//! - `design`: one design: its motion by closed forms until it rests, and by integration where
//!   there are none.
//! - `decision`: what decides the best design: sensitivities, what is as good, corner, flat
//!   direction or trade.
//! - `study`: all runs, and what stands beside them.
//!
//! ```
//! # use lindstedt_impact as lindstedt;
//! use lindstedt::optimize::{OptimizationProblem, StudyObserver, optimize};
//!
//! let mut question = OptimizationProblem { runs: 2, ..OptimizationProblem::default() };
//! question.genetic.population = 20;
//! question.genetic.generations = 10;
//! let study = optimize(question, vec![], &StudyObserver::default())?;
//! let best = study.best().ok_or("a design that rests")?;
//! assert!(best.design.point[2] < 0.031); // the shortest pendulum rests soonest, in seconds
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod decision;
mod design;
mod objective;
mod question;
mod study;

pub use decision::{Decision, Ends, Sensitivity, VariableRole, WITHIN};
pub use design::{EvaluatedDesign, HardestContact, Route};
pub use objective::Objective;
pub use question::{DEFAULT_BOX, Limit, OptimizationProblem, OptimizeError, Variable};
#[cfg(feature = "parallel")]
pub use study::optimize_on;
pub use study::{
    BaselineSearch, Finalist, FiveNumberSummary, Found, SearchRun, Study, StudyObserver, optimize,
};

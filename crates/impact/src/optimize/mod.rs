//! The best damper: a genetic search for the design that rests soonest, and the factors that limit
//! it.
//!
//! In: an [`OptimizationProblem`]: the variables and their limits, the parameters held fixed, the
//! objectives, the options of the search. Out: a [`Study`]: the best design verified by
//! integration, the spread of many runs, other searches with the same number of evaluations, the
//! default design under the same assumptions, and the factors that limit the best design: a
//! [`Decision`]. With several objectives at once it is the Pareto front.
//!
//! - `objective`: the quantities that may be minimised or limited, one row each.
//! - `question`: the box, the constraints, the options.
//! - `design`: one design: its motion by closed forms until it rests, and by integration where
//!   there are none.
//! - `decision`: the limiting factors: sensitivities, equally good designs, and the role of each
//!   variable.
//! - `study`: all runs, and the comparisons.
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
mod known;
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
    search_runs,
};

//! Search by a genetic algorithm: a population of points of a box, of which better ones become
//! parents more often. The module handles numbers and functions of them, whatever they stand for.
//!
//! In: a [`Space`], a function that gives every point an [`Evaluation`], [`GeneticOptions`], a
//! generator of random numbers. Out: a [`GeneticRun`]: the best point that keeps the constraints,
//! and how the best value came down from generation to generation. One generation is
//!
//! ```text
//! score -> scale by rank -> select parents -> elite + children by crossover + children by mutation -> score
//! ```
//!
//! Each operator has a file, under the name that users of MATLAB's `ga` know. The operators are
//! written from descriptions of their behaviour, and tests check their properties:
//!
//! - `space`: the box.
//! - `coding`: numbers as they are, or as strings of bits.
//! - `scaling`: [`rank_scaling`], expectations by rank.
//! - `selection`: [`stochastic_uniform`] (J. E. Baker, *Proc. 2nd Int. Conf. on Genetic
//!   Algorithms*, 1987, 14).
//! - `crossover`: [`heuristic`] (A. H. Wright, *Foundations of Genetic Algorithms*, 1991, 205),
//!   [`scattered`], [`one_point`].
//! - `mutation`: [`adaptive_feasible`], an algorithm of our own under a known name, and
//!   [`bit_flips`].
//! - `penalty`: the score of a point that violates a constraint.
//! - `stopping`: the test of whether the best value has ceased to change.
//! - `population`: the generations of one run: [`search`].
//! - `pareto`, `nsga`: several functions at once (K. Deb et al., *IEEE Trans. Evol. Comput.* 6
//!   (2002) 182): [`search_front`].
//! - `rivals`: [`random_search`] and [`differential_evolution`] on the same budget.
//!
//! ```
//! # use lindstedt_numeric as lindstedt;
//! use lindstedt::genetic::{Evaluation, GeneticOptions, Space, generator, one_by_one, search};
//!
//! let space = Space::new(vec![[-1.0, 2.0], [-1.0, 2.0]])?;
//! let paraboloid = |point: &[f64]| Evaluation::unconstrained(point.iter().map(|x| x * x).sum());
//! let run = search(&space, one_by_one(paraboloid), &GeneticOptions::default(), &mut generator(1, 0), &mut |_| true);
//! assert!(run.best.is_some_and(|best| best.evaluation.objectives[0] < 1e-6));
//! # Ok::<(), lindstedt::genetic::SearchError>(())
//! ```

mod coding;
mod crossover;
mod mutation;
mod nsga;
mod pareto;
mod penalty;
mod population;
mod rivals;
mod scaling;
mod selection;
mod space;
mod stopping;

pub use coding::Coding;
pub use crossover::{Crossover, heuristic, one_point, scattered};
pub use mutation::{Mutation, SMALLEST_STEP, adaptive_feasible, bit_flips, next_step};
pub use nsga::{polynomial_mutation, search_front, simulated_binary};
pub use pareto::{crowding, dominates, non_dominated, ranks};
pub use penalty::{Multipliers, Penalty, scores};
pub use population::{GeneticOptions, GeneticRun, Individual, SearchError, one_by_one, search};
pub use rivals::{differential_evolution, random_search};
pub use scaling::rank_scaling;
pub use selection::stochastic_uniform;
pub use space::{Evaluation, Space};
pub use stopping::{GeneticStop, StallTest, has_stalled};

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Returns the random number generator of one run: stream `stream` of ChaCha8 with this seed, the
/// same on every machine. Streams of one seed are independent, so runs may follow each other in any
/// order, on any number of threads.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use rand::RngExt;
///
/// let first: Vec<u32> = (0..3).map(|stream| lindstedt::genetic::generator(1, stream).random()).collect();
/// assert!(first[0] != first[1] && first[1] != first[2]);
/// ```
pub fn generator(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(stream);
    generator
}

//! A balance of harmonics solved by numbers: the branch that starts at rest, followed in the
//! amplitude.
//!
//! References: M. Krack, J. Gross, *Harmonic Balance for Nonlinear Vibration Problems*, Springer
//! 2019, chapter 4; E. L. Allgower, K. Georg, *Introduction to Numerical Continuation Methods*,
//! SIAM 2003, chapters 2 and 6 (arclength, steps).
//!
//! ```text
//! x = alpha sum_k b_k cos(k theta),   F_k = c_k/alpha - k^2 w b_k = 0,   sum_k b_k = +-1,   w = omega^2
//! c_k = (2/pi) int_0^pi f(x) cos(k theta) dtheta                                           (c_0 counts half)
//! unknowns ln w, b_k, ln alpha: one more than equations; predicted along the tangent, corrected at right angles to it
//! ```
//!
//! In these unknowns nothing depends on units: at small amplitudes `b_1 = 1` and all others vanish,
//! or, for a force without linear part such as `x^3`, keep the values that belong to its lowest
//! power. Where that branch turns back before it reaches the amplitude asked for, there may be
//! others, about several wells or about this one: they are followed down from amplitudes so large
//! that the highest power alone decides. Where there are none either, the balance is refused in
//! words. Motions through an unstable equilibrium have no branch from rest: theirs is followed from
//! an amplitude at which they are nearly of one term.
//!
//! Integrals are sums: over equal steps, exact for polynomials of degree `d` beyond `(d + 1) k/2`
//! points; and over Gauss points between the instants at which the motion crosses a corner, a jump
//! or a narrow place of the force; finer ones are used where a force oscillates more often than
//! they resolve.
//!
//! Cost: with `n` harmonics and `m` samples, `O(m n + n^3)` for each of Newton's steps.

use std::cell::{Cell, OnceCell, RefCell};
use std::f64::consts::PI;
use std::rc::Rc;

use nalgebra::{DMatrix, DVector};

use super::numbers::NoNumbers;
use crate::conservative::force::CentredForce;
use crate::conservative::passage::{passage_at, passages, pushes_away};
use crate::exact::Doubles;
use crate::numeric::continuation::ContinuationStep::{Ended, Taken, TooLong};
use crate::numeric::continuation::{self, bordered, follow};
use crate::numeric::ode::quadrature::nodes_and_weights;
use crate::numeric::ode::root::find_root;
use crate::series::FourierSeries;

/// A balance solved by numbers.
pub struct BalanceSolution {
    /// omega^2.
    pub frequency_squared: f64,
    /// The motion about the equilibrium.
    pub motion: FourierSeries<Doubles>,
    /// The largest amplitude that the branch from rest reaches, if that is less than this one: the
    /// motion was then followed down from large amplitudes.
    pub rest_ends_at: Option<f64>,
    /// Whether it passes other equilibria on its way.
    pub over_several_wells: bool,
}

/// The known motions on the branch from rest of one balance, for a fixed force and fixed harmonics,
/// from the amplitudes solved before: the next amplitude is reached from the nearest known one
/// below it instead of from rest.
#[derive(Debug, Default)]
pub struct Continuation {
    states: RefCell<Vec<BalanceUnknowns>>,
    /// Refinement factor of the sums of the last solution; 0 if there is none yet.
    fineness: Cell<usize>,
    /// Number of failed continuations of motions over several wells.
    failures: Cell<usize>,
}

impl Continuation {
    /// The motion of the known amplitude nearest to this one, on its side.
    fn nearest(&self, amplitude: f64) -> Option<BalanceUnknowns> {
        let goal = amplitude.abs().ln();
        let known = self.states.borrow();
        let distance = |state: &BalanceUnknowns| (state.logarithm() - goal).abs();
        let reached = known.iter().filter(|state| state.side() == amplitude.signum());
        reached.min_by(|one, other| distance(one).total_cmp(&distance(other))).cloned()
    }

    /// The motion of the largest amplitude known that is no larger than this one, which is on this
    /// side.
    fn below(&self, amplitude: f64) -> Option<BalanceUnknowns> {
        let goal = amplitude.abs().ln();
        let known = self.states.borrow();
        let reached = known
            .iter()
            .filter(|state| state.logarithm() <= goal && state.side() == amplitude.signum());
        reached.max_by(|one, other| one.logarithm().total_cmp(&other.logarithm())).cloned()
    }
}

/// Solves the balance of `harmonics` for the motion with `x(0) = amplitude` about the equilibrium.
/// `degree` is that of a polynomial force.
///
/// # Errors
/// [`NoNumbers`].
pub fn balance(
    force: &CentredForce,
    degree: Option<u32>,
    harmonics: &[usize],
    amplitude: f64,
    known: &Continuation,
) -> Result<BalanceSolution, NoNumbers> {
    /// Largest number of features along the motion, such as the waves of a sine: a few harmonics
    /// cannot represent more, and the sums would take long.
    const MOST_CUTS: usize = 600;
    let mut problem =
        BalanceProblem::new(force, degree, harmonics, amplitude).ok_or(NoNumbers::NoBalance)?;
    problem.fineness = known.fineness.get().max(1);
    if problem.cuts.len() > MOST_CUTS {
        return Err(NoNumbers::UnsettledBalance);
    }
    let (mut state, rest_ends_at) = problem.followed(known)?;
    if degree.is_none() {
        state = problem.refined(state)?;
    }
    let highest = harmonics.last().copied().unwrap_or(0);
    let mut cosine = vec![0.0; highest + 1];
    for (&k, value) in harmonics.iter().zip(state.shape(problem.count).iter()) {
        cosine[k] = value * amplitude.abs();
    }
    let motion = FourierSeries::from_parts(Doubles, cosine, vec![]);
    let (low, high) = problem.range(&state);
    if degree.is_none()
        && let Some(place) = force.gap(low, high)
    {
        return Err(NoNumbers::BalanceGap { place });
    }
    Ok(BalanceSolution {
        frequency_squared: state.frequency_squared(),
        motion,
        rest_ends_at,
        over_several_wells: !problem.is_pulled_back(low, high),
    })
}

/// The last of these motions up to which, from the first on, the shape does not change; `None` if
/// the first ones differ.
fn converged<'s>(motions: &[&'s (BalanceUnknowns, f64)]) -> Option<&'s (BalanceUnknowns, f64)> {
    let first = motions.first()?.1;
    let same = motions.iter().take_while(|entry| (entry.1 - first).abs() <= 1e-6);
    same.last().copied()
}

/// `ln w`, `b_k`, `ln alpha`.
#[derive(Clone, Debug)]
struct BalanceUnknowns(DVector<f64>);

impl BalanceUnknowns {
    fn frequency_squared(&self) -> f64 {
        self.0[0].exp()
    }

    fn shape(&self, count: usize) -> DVector<f64> {
        self.0.rows(1, count).into_owned()
    }

    fn logarithm(&self) -> f64 {
        self.0[self.0.len() - 1]
    }

    /// The side of the release, by `sum_k b_k = +-1`.
    fn side(&self) -> f64 {
        self.0.rows(1, self.0.len() - 2).sum().signum()
    }
}

struct BalanceProblem<'a> {
    force: &'a CentredForce,
    harmonics: &'a [usize],
    count: usize,
    /// Index of the first harmonic.
    first: usize,
    /// Points of equal steps that are enough for a polynomial, or to begin with.
    points: usize,
    polynomial: bool,
    /// Refinement factor of the sums.
    fineness: usize,
    amplitude: f64,
    /// Narrow places and corners of the force, up to the distance `reach`.
    cuts: Vec<f64>,
    reach: f64,
    /// The points of equal steps, once they have been needed.
    equal_steps: OnceCell<Rc<Nodes>>,
}

/// Nodes of a sum over the period, with the weights of the force and of its slope.
struct Nodes {
    /// One row of cosines of the harmonics for each point.
    cosines: DMatrix<f64>,
    weights: Vec<f64>,
    /// A jump of the force, over the speed at which it is crossed; `None` at a point of the sum.
    jumps: Vec<Option<f64>>,
}

impl<'a> BalanceProblem<'a> {
    fn new(
        force: &'a CentredForce,
        degree: Option<u32>,
        harmonics: &'a [usize],
        amplitude: f64,
    ) -> Option<Self> {
        let highest = *harmonics.last()?;
        let reach = 3.0 * amplitude.abs();
        let cuts = match degree {
            Some(_) => vec![],
            None => force.cuts(-reach, reach),
        };
        Some(Self {
            cuts,
            reach,
            force,
            harmonics,
            count: harmonics.len(),
            first: harmonics.iter().position(|&k| k == 1)?,
            points: degree
                .map_or(8 * highest + 32, |degree| (degree as usize + 1) * highest / 2 + 2),
            polynomial: degree.is_some(),
            fineness: 1,
            equal_steps: OnceCell::new(),
            amplitude: (amplitude.is_finite() && amplitude != 0.0).then_some(amplitude)?,
        })
    }

    fn side(&self) -> f64 {
        self.amplitude.signum()
    }

    /// The smallest and the largest distance from the equilibrium along a motion.
    fn range(&self, state: &BalanceUnknowns) -> (f64, f64) {
        const SAMPLES: usize = 256;
        let alpha = state.logarithm().exp();
        let value = |i: usize| alpha * self.displacement(state, PI * i as f64 / SAMPLES as f64);
        (0..=SAMPLES)
            .map(value)
            .fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)))
    }

    /// `sum b_k cos(k theta)`.
    fn displacement(&self, state: &BalanceUnknowns, theta: f64) -> f64 {
        let wave = |(j, &k): (usize, &usize)| state.0[j + 1] * (k as f64 * theta).cos();
        self.harmonics.iter().enumerate().map(wave).sum()
    }

    fn velocity(&self, state: &BalanceUnknowns, theta: f64) -> f64 {
        let wave =
            |(j, &k): (usize, &usize)| -(k as f64) * state.0[j + 1] * (k as f64 * theta).sin();
        self.harmonics.iter().enumerate().map(wave).sum()
    }

    /// The points for sums along this motion, `finer` times as many as this problem uses.
    fn nodes(&self, state: &BalanceUnknowns, finer: usize) -> Rc<Nodes> {
        let once = finer == 1;
        let finer = finer * self.fineness;
        let cuts = if self.polynomial {
            vec![]
        } else {
            let (low, high) = self.range(state);
            let reach = f64::max(high, -low);
            if reach <= self.reach {
                self.cuts.clone()
            } else {
                self.force.cuts(-1.25 * reach, 1.25 * reach)
            }
        };
        if cuts.is_empty() {
            let points = self.points * finer;
            let equal_steps = || {
                let angles: Vec<f64> =
                    (0..points).map(|i| PI * (i as f64 + 0.5) / points as f64).collect();
                Rc::new(self.with_cosines(
                    &angles,
                    vec![PI / points as f64; points],
                    vec![None; points],
                ))
            };
            return match once {
                true => self.equal_steps.get_or_init(equal_steps).clone(),
                false => equal_steps(),
            };
        }
        let (angles, weights, jumps) = self.between_crossings(state, &cuts, finer);
        Rc::new(self.with_cosines(&angles, weights, jumps))
    }

    fn with_cosines(&self, angles: &[f64], weights: Vec<f64>, jumps: Vec<Option<f64>>) -> Nodes {
        Nodes {
            cosines: DMatrix::from_fn(angles.len(), self.count, |i, j| {
                (self.harmonics[j] as f64 * angles[i]).cos()
            }),
            weights,
            jumps,
        }
    }

    /// Gauss points between the instants at which the motion crosses one of the `cuts`, and those
    /// instants themselves.
    fn between_crossings(
        &self,
        state: &BalanceUnknowns,
        cuts: &[f64],
        finer: usize,
    ) -> (Vec<f64>, Vec<f64>, Vec<Option<f64>>) {
        let alpha = state.logarithm().exp();
        let highest = self.harmonics.last().copied().unwrap_or(1);
        let steps = 8 * highest + 64;
        let place = |i: usize| PI * i as f64 / steps as f64;
        let positions: Vec<f64> =
            (0..=steps).map(|i| alpha * self.displacement(state, place(i))).collect();
        let mut crossings: Vec<(f64, f64)> = Vec::new();
        for (i, pair) in positions.windows(2).enumerate() {
            for &cut in cuts.iter().filter(|&&cut| (pair[0] - cut) * (pair[1] - cut) <= 0.0) {
                let excess = |theta: f64| alpha * self.displacement(state, theta) - cut;
                if let Ok(theta) = find_root(excess, place(i), place(i + 1)) {
                    crossings.push((theta, cut));
                }
            }
        }
        crossings.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut ends: Vec<f64> = crossings.iter().map(|crossing| crossing.0).collect();
        ends.insert(0, 0.0);
        ends.push(PI);
        let (mut angles, mut weights, mut jumps) = (vec![], vec![], vec![]);
        for pair in ends.windows(2) {
            let length = pair[1] - pair[0];
            if length <= 1e-14 {
                continue;
            }
            // Twenty Gauss points for every few waves of the highest harmonic.
            let pieces = (1 + (length * highest as f64 / 8.0) as usize) * finer;
            for piece in 0..pieces {
                let at = |part: usize| part as f64 / pieces as f64;
                // Points crowd at both ends, where a root or a corner makes the force not smooth.
                for (u, weight) in nodes_and_weights(at(piece), at(piece + 1)) {
                    angles.push(pair[0] + length * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u));
                    weights.push(weight * length * 30.0 * (u * (1.0 - u)).powi(2));
                    jumps.push(None);
                }
            }
        }
        for (theta, cut) in crossings {
            let step = 1e-9 * alpha;
            let jump = self.force.value(cut + step) - self.force.value(cut - step);
            let speed = alpha * self.velocity(state, theta).abs();
            let size = self.force.value(cut + step).abs().max(self.force.value(cut - step).abs());
            if jump.abs() > 1e-5 * size && speed > 0.0 {
                angles.push(theta);
                weights.push(0.0);
                jumps.push(Some(jump / speed));
            }
        }
        (angles, weights, jumps)
    }

    /// The equations and their derivatives by all unknowns, in units of `w`.
    fn equations(
        &self,
        state: &BalanceUnknowns,
        nodes: &Nodes,
    ) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let count = self.count;
        let (w, alpha) = (state.frequency_squared(), state.logarithm().exp());
        let shape = state.shape(count);
        let position = alpha * (&nodes.cosines * &shape);
        let unit = alpha * w;
        let (mut forces, mut slopes) = (position.clone(), position.clone());
        for (i, &y) in position.iter().enumerate() {
            match nodes.jumps[i] {
                Some(jump) => (forces[i], slopes[i]) = (0.0, jump / w),
                None => {
                    forces[i] = nodes.weights[i] * self.force.value(y) / unit;
                    slopes[i] = nodes.weights[i] * self.force.slope(y) / w;
                }
            }
        }
        if forces.iter().chain(slopes.iter()).any(|value| !value.is_finite()) {
            return None;
        }
        let mut weighted = nodes.cosines.clone();
        for mut column in weighted.column_iter_mut() {
            column.component_mul_assign(&slopes);
        }
        let projected = nodes.cosines.transpose() * &forces;
        let products = nodes.cosines.transpose() * &weighted;
        let mut residual = DVector::zeros(count + 1);
        let mut jacobian = DMatrix::zeros(count + 1, count + 2);
        for (row, &k) in self.harmonics.iter().enumerate() {
            let share = if k == 0 { 1.0 } else { 2.0 } / PI;
            let inertia = (k * k) as f64;
            residual[row] = share * projected[row] - inertia * shape[row];
            jacobian[(row, 0)] = -inertia * shape[row];
            let mut along = 0.0;
            for column in 0..count {
                let entry = share * products[(row, column)];
                jacobian[(row, column + 1)] = entry;
                along += entry * shape[column];
            }
            jacobian[(row, row + 1)] -= inertia;
            jacobian[(row, count + 1)] = along - share * projected[row];
        }
        residual[count] = shape.sum() - self.side();
        for column in 0..count {
            jacobian[(count, column + 1)] = 1.0;
        }
        Some((residual, jacobian))
    }

    /// Newton's iteration from `start`, every step at right angles to `direction`.
    fn corrected(
        &self,
        start: &BalanceUnknowns,
        direction: &DVector<f64>,
        finer: usize,
        iterations: usize,
    ) -> Option<BalanceUnknowns> {
        let mut state = start.clone();
        let mut last = f64::INFINITY;
        for _ in 0..iterations {
            let (residual, jacobian) = self.equations(&state, &self.nodes(&state, finer))?;
            let change = bordered(&jacobian, direction).lu().solve(&residual.push(0.0))?;
            state.0 -= &change;
            let moved = change.amax();
            if !moved.is_finite() || moved > 5.0 {
                return None;
            }
            // Rounding may keep the last digits moving.
            if moved <= 1e-14 || (moved <= 1e-10 && moved >= 0.5 * last) {
                return Some(state);
            }
            last = moved;
        }
        (last <= 1e-9).then_some(state)
    }

    /// Newton's method at fixed amplitude.
    fn at_amplitude(&self, start: &BalanceUnknowns, finer: usize) -> Option<BalanceUnknowns> {
        const ITERATIONS: usize = 40;
        let mut direction = DVector::zeros(self.count + 2);
        direction[self.count + 1] = 1.0;
        self.corrected(start, &direction, finer, ITERATIONS)
    }

    /// The motion of one term, and how large its first corrections are.
    fn one_term_guess(&self, amplitude: f64) -> Option<(BalanceUnknowns, f64)> {
        let mut state = BalanceUnknowns(DVector::zeros(self.count + 2));
        state.0[self.first + 1] = self.side();
        state.0[self.count + 1] = amplitude.abs().ln();
        let nodes = self.nodes(&state, 1);
        let position = amplitude.abs() * (&nodes.cosines * state.shape(self.count));
        let forces = DVector::from_fn(position.len(), |i, _| match nodes.jumps[i] {
            Some(_) => 0.0,
            None => nodes.weights[i] * self.force.value(position[i]),
        });
        let parts = nodes.cosines.transpose() * forces * (2.0 / PI / amplitude);
        let w = parts[self.first];
        if !(w > 0.0 && w.is_finite()) {
            return None;
        }
        state.0[0] = w.ln();
        let correction = |(part, &k): (&f64, &usize)| (part / (w * (k * k).max(1) as f64)).abs();
        let all: f64 = parts.iter().zip(self.harmonics).map(correction).sum();
        Some((state, all - 1.0)).filter(|found| found.1.is_finite())
    }

    /// A motion of small amplitude: the nearest that has the linear frequency and nearly is its
    /// first harmonic alone, or, where the force has no linear part, the nearest below which the
    /// shape no longer changes, as for a power of x.
    fn small_amplitude_start(&self) -> Option<BalanceUnknowns> {
        /// Largest corrections, and largest difference from the linear frequency, of a motion on
        /// the branch from rest.
        const NEARLY_ALONE: f64 = 0.01;
        const NEARLY_LINEAR: f64 = 0.05;
        let linear = self.force.slope(0.0);
        let mut tried: Vec<(BalanceUnknowns, f64)> = Vec::new();
        for halving in (0..25).chain([30, 40, 60, 100]) {
            let amplitude = self.amplitude * 0.5_f64.powi(halving);
            let Some((alone, corrections)) = self.one_term_guess(amplitude) else {
                continue;
            };
            if corrections <= NEARLY_ALONE
                && (alone.frequency_squared() / linear - 1.0).abs() <= NEARLY_LINEAR
                && let Some(found) = self.solve_near(&alone, 0.05)
            {
                return Some(found);
            }
            tried.push((alone, corrections));
        }
        let upwards: Vec<&(BalanceUnknowns, f64)> = tried.iter().rev().collect();
        self.solve_near(&converged(&upwards)?.0, 0.5)
    }

    /// A motion of so large an amplitude that its shape no longer changes beyond it.
    fn large_amplitude_start(&self) -> Option<BalanceUnknowns> {
        const DOUBLINGS: i32 = 40;
        let tried: Vec<Option<(BalanceUnknowns, f64)>> = (0..=DOUBLINGS)
            .map(|doubling| self.one_term_guess(self.amplitude * 2.0_f64.powi(doubling)))
            .collect();
        // Far out the force may overflow.
        let felt = tried.iter().rposition(Option::is_some)?;
        let downwards: Vec<&(BalanceUnknowns, f64)> =
            tried[..=felt].iter().rev().map_while(Option::as_ref).collect();
        self.solve_near(&converged(&downwards)?.0, 0.5)
    }

    /// A solution close to a guess.
    fn solve_near(&self, guess: &BalanceUnknowns, distance: f64) -> Option<BalanceUnknowns> {
        self.at_amplitude(guess, 1).filter(|found| (&found.0 - &guess.0).amax() <= distance)
    }

    /// Follows the branch from rest to the amplitude, or else that from large amplitudes; then the
    /// amplitude at which the branch from rest ends is returned as well. The sums are refined if
    /// the branch ends only because they are too coarse.
    fn followed(
        &mut self,
        known: &Continuation,
    ) -> Result<(BalanceUnknowns, Option<f64>), NoNumbers> {
        if pushes_away(self.force, self.amplitude) {
            return self.follow_cross_well_branch(known).map(|found| (found, None));
        }
        const FINER: usize = 4;
        const FINEST: usize = 64;
        /// Smallest step in ln A that counts as progress.
        const AHEAD: f64 = 0.01;
        let mut before = f64::NEG_INFINITY;
        let end = loop {
            let end = match self.follow_from_rest(known).ok_or(NoNumbers::NoBalance)? {
                Ok(found) => return Ok((found, None)),
                Err(end) => end,
            };
            let ahead = end.logarithm() > before + AHEAD;
            if self.fineness >= FINEST || !ahead || !self.is_too_coarse(&end) {
                break end;
            }
            before = end.logarithm();
            self.fineness *= FINER;
            self.equal_steps.take();
        };
        let amplitude = end.logarithm().exp() * self.side();
        // If the true motion stays in one of several wells, a solution that passes all of them is
        // discarded.
        let fits = |found: &BalanceUnknowns| {
            let (low, high) = self.range(found);
            self.is_pulled_back(low, high) || self.runs_over_several_wells()
        };
        let outer = self.large_amplitude_start();
        let outer = outer.and_then(|large| self.followed_from(large, -1.0, &mut Vec::new()).ok());
        let found = outer.filter(fits).map(|found| (found, Some(amplitude)));
        found.ok_or(NoNumbers::BalanceEnds { amplitude })
    }

    /// The branch of motions through an unstable equilibrium, over the wells on both sides, from
    /// what is known of it or from an amplitude nearby at which one term is nearly all.
    fn follow_cross_well_branch(&self, known: &Continuation) -> Result<BalanceUnknowns, NoNumbers> {
        /// Number of starts that are tried, at up to four times the amplitude unless the range ends
        /// before.
        const STARTS: usize = 6;
        const PER_DOUBLING: i32 = 3;
        /// Largest number of failed starts for all amplitudes together: each takes long in a force
        /// of many waves.
        const MOST_IN_VAIN: usize = 12;
        let passages = passages(self.force, self.amplitude);
        let range = passage_at(&passages, self.amplitude).ok_or(NoNumbers::NoBalance)?;
        let end = range.to.map_or(f64::INFINITY, |rim| rim.place);
        let goal = self.amplitude.abs().ln();
        let reached = |start: BalanceUnknowns| {
            let way = (goal - start.logarithm()).signum();
            let mut passed = Vec::new();
            let found = self.followed_from(start, way, &mut passed);
            known.states.borrow_mut().append(&mut passed);
            found
        };
        let nearest = known.nearest(self.amplitude).and_then(|state| self.solve_near(&state, 0.05));
        if let Some(Ok(found)) = nearest.map(&reached) {
            return Ok(found);
        }
        if known.failures.get() >= MOST_IN_VAIN {
            return Err(NoNumbers::NoBalance);
        }
        let sizes = (-3 * PER_DOUBLING..=2 * PER_DOUBLING)
            .map(|k| 2.0_f64.powf(f64::from(k) / f64::from(PER_DOUBLING)));
        let sizes = sizes.map(|factor| factor * self.amplitude.abs());
        let mut alone: Vec<(BalanceUnknowns, f64)> = sizes
            .filter(|&size| size > range.from && size < end)
            .filter_map(|size| self.one_term_guess(size * self.side()))
            .collect();
        // Good starts are nearly of one term, and close to the amplitude.
        let merit = |(state, corrections): &(BalanceUnknowns, f64)| {
            corrections + 0.1 * (state.logarithm() - goal).abs()
        };
        alone.sort_by(|one, other| merit(one).total_cmp(&merit(other)));
        let mut lost = NoNumbers::NoBalance;
        let starts = alone.iter().filter_map(|(alone, _)| self.solve_near(alone, 0.5));
        for start in starts.take(STARTS) {
            let from = start.logarithm().exp() * self.side();
            let found = reached(start);
            known.failures.set(known.failures.get() + usize::from(found.is_err()));
            match found {
                Ok(found) => return Ok(found),
                Err(last) if lost == NoNumbers::NoBalance => {
                    let amplitude = last.logarithm().exp() * self.side();
                    lost = NoNumbers::CrossWellBalanceEnds { from, amplitude };
                }
                Err(_) => {}
            }
        }
        Err(lost)
    }

    /// The branch from rest, or from what is known of it, to the amplitude; or its end. `None` if
    /// there is no motion at rest.
    fn follow_from_rest(
        &self,
        known: &Continuation,
    ) -> Option<Result<BalanceUnknowns, BalanceUnknowns>> {
        let mut passed = Vec::new();
        // The start is corrected with the sums of this problem, which may be finer than those it
        // was found with.
        let nearest = known.below(self.amplitude);
        let nearest = nearest.and_then(|state| self.solve_near(&state, 0.05));
        let mut found =
            nearest.and_then(|nearest| self.followed_from(nearest, 1.0, &mut passed).ok());
        if found.is_none() {
            passed.clear();
            match self.followed_from(self.small_amplitude_start()?, 1.0, &mut passed) {
                Ok(reached) => found = Some(reached),
                Err(end) => return Some(Err(end)),
            }
        }
        known.states.borrow_mut().append(&mut passed);
        known.fineness.set(self.fineness);
        found.map(Ok)
    }

    /// Whether the force oscillates more often than the sums resolve: with finer ones this is not a
    /// solution.
    fn is_too_coarse(&self, state: &BalanceUnknowns) -> bool {
        const FINER: usize = 4;
        const AGREEING: f64 = 1e-7;
        let residual =
            |finer: usize| Some(self.equations(state, &self.nodes(state, finer))?.0.amax());
        !self.polynomial
            && self.force.waves()
            && residual(FINER).is_some_and(|residual| residual > AGREEING)
    }

    /// Whether the force pulls back everywhere between two distances on either side of the
    /// equilibrium, so that there is no other equilibrium.
    fn is_pulled_back(&self, low: f64, high: f64) -> bool {
        const SAMPLES: i32 = 1000;
        // Samples in geometric steps resolve the surroundings of the equilibrium, equal steps the
        // rest.
        let parts =
            (1..SAMPLES).flat_map(|k| [0.97_f64.powi(k), f64::from(k) / f64::from(SAMPLES)]);
        let mut places = parts.flat_map(|part| [part * low, part * high]).filter(|&x| x != 0.0);
        places.all(|x| x * self.force.value(x) > 0.0)
    }

    /// Whether the true motion passes other equilibria on its way.
    fn runs_over_several_wells(&self) -> bool {
        const SAMPLES: i32 = 1000;
        let Ok(end) = self.force.turning_point(self.amplitude) else {
            return false;
        };
        let pushes_away = |x: f64| x * self.force.value(x) < 0.0;
        // Wells may be far smaller than the motion.
        let near = |k: i32| 0.97_f64.powi(k);
        let even = |k: i32| f64::from(k) / f64::from(SAMPLES);
        (1..SAMPLES).any(|k| {
            [near(k), even(k)]
                .iter()
                .any(|part| pushes_away(part * end) || pushes_away(part * self.amplitude))
        })
    }

    /// The branch from its start to the amplitude, `way` being one upwards and minus one downwards;
    /// the motions that it passes are added to `passed`.
    ///
    /// # Errors
    /// The last motion, where the branch does not reach the amplitude.
    fn followed_from(
        &self,
        start: BalanceUnknowns,
        way: f64,
        passed: &mut Vec<BalanceUnknowns>,
    ) -> Result<BalanceUnknowns, BalanceUnknowns> {
        const LONGEST: f64 = 0.5;
        const SHORTEST: f64 = 1e-6;
        const STEPS: usize = 3000;
        /// A correction longer than this share of its step may lead to another branch: the step was
        /// too long for the curvature.
        const SHARE: f64 = 0.2;
        let goal = self.amplitude.abs().ln();
        let (amplitude, mut steps) = (self.count + 1, 0);
        let mut direction = DVector::zeros(amplitude + 1);
        direction[amplitude] = way;
        let step = |passed: &[BalanceUnknowns], length: &mut f64| {
            let state = &passed[passed.len() - 1];
            let left = goal - state.logarithm();
            steps += 1;
            if left.abs() < 1e-12 || steps > STEPS {
                return Ended(None, left.abs() < 1e-12);
            }
            // Beyond a fold the branch would return to amplitudes that it has passed, with another
            // motion.
            let tangent = self.tangent(state, &direction);
            let Some(tangent) = tangent.filter(|tangent| way * tangent[amplitude] > 0.0) else {
                return Ended(None, false);
            };
            // The correction of the step before may have carried the branch past the goal, by less
            // than that step.
            let left = left / tangent[amplitude];
            let last = left <= *length;
            *length = length.min(left);
            let mut predicted = BalanceUnknowns(&state.0 + *length * &tangent);
            let found = if last {
                predicted.0[amplitude] = goal;
                self.at_amplitude(&predicted, 1)
            } else {
                self.corrected(&predicted, &tangent, 1, 12)
            };
            let near =
                |found: &BalanceUnknowns| (&found.0 - &predicted.0).norm() <= SHARE * length.abs();
            match found.filter(near) {
                Some(found) if last => Ended(Some(found), true),
                Some(found) => {
                    direction = tangent;
                    Taken(found, 1.7)
                }
                None if 0.5 * *length < SHORTEST => Ended(None, false),
                None => TooLong,
            }
        };
        let (states, reached) = follow(start, LONGEST / 4.0, LONGEST, step);
        let end = states[states.len() - 1].clone();
        passed.extend(states.into_iter().skip(1));
        if reached { Ok(end) } else { Err(end) }
    }

    /// The direction of the branch, forward.
    fn tangent(&self, state: &BalanceUnknowns, before: &DVector<f64>) -> Option<DVector<f64>> {
        let (_, jacobian) = self.equations(state, &self.nodes(state, 1))?;
        let tangent = continuation::tangent(&bordered(&jacobian, before).lu())?;
        let norm = tangent.norm();
        (norm.is_finite() && norm > 0.0).then(|| tangent / norm)
    }

    /// Refines a solution by finer and finer sums, until two agree.
    fn refined(&self, mut state: BalanceUnknowns) -> Result<BalanceUnknowns, NoNumbers> {
        const MOST_POINTS: usize = 1 << 17;
        /// Largest change from one refinement to the next that is accepted: the digits that a user
        /// sees.
        const ENOUGH: f64 = 1e-8;
        let (mut finer, mut change) = (1, f64::INFINITY);
        while change >= 1e-12 && 2 * finer * self.nodes(&state, 1).weights.len() <= MOST_POINTS {
            finer *= 2;
            let Some(next) = self.at_amplitude(&state, finer) else {
                break;
            };
            change = (&next.0 - &state.0).amax();
            state = next;
        }
        match change < ENOUGH {
            true => Ok(state),
            false => Err(NoNumbers::UnsettledBalance),
        }
    }
}

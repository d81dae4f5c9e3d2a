//! Branches of periodic orbits of equations with any number of states, by shooting: pseudo-arclength
//! on the map of a period.
//!
//! ```text
//! P(y; p) = y,   M = dP/dy          [M - 1   P_p]        [P - y            ]
//!                                   [    t^T    ] du = - [t . (u - guess)  ]
//! ```
//!
//! The multipliers of each orbit are known with it, and no truncation is involved, however sharp the
//! turns of a motion are (H. B. Keller, in *Applications of Bifurcation Theory*, Academic Press
//! 1977; R. Seydel, *Practical Bifurcation and Stability Analysis*, Springer 2010, chapters 4 and
//! 7). In: the map of a period with its derivatives, as a closure. Out: the orbits of a branch, both
//! ways, with tangents, and the reasons why it ends.
//!
//! Without a drive the period T is an unknown, and the orbit may begin anywhere on itself. It is then
//! one more state, which the map changes by a condition on the beginning, s(y) = 0, that fixes the
//! place on the orbit: `(y, T) -> (P(y, T), T + s(y))`. The condition is to be the same along the
//! branch, so that its points lie on one curve.
//!
//! A point of a smooth branch costs one or two periods with their variations, another one two or three, and as
//! many linear equations of n + 1 unknowns.

mod prediction;

use nalgebra::{DMatrix, DVector, Dyn, LU};

use super::continuation::{self, ContinuationStep, passes, sign_of_determinant, tangent};
use crate::interrupt::Interrupt;
use prediction::predicted;

/// A motion over a period with its derivatives.
#[derive(Clone, Debug)]
pub struct PeriodImage<Path> {
    /// The state after the period.
    pub end: DVector<f64>,
    /// Its derivative by the state at the beginning.
    pub by_start: DMatrix<f64>,
    /// Its derivative by the parameter.
    pub by_parameter: DVector<f64>,
    /// The motion as it was followed.
    pub path: Path,
}

/// An orbit of a branch.
#[derive(Clone, Debug)]
pub struct OrbitPoint<Kept> {
    /// The state at the beginning, then the parameter.
    pub unknowns: DVector<f64>,
    /// The derivative of the state after a period by the state at the beginning.
    pub monodromy: DMatrix<f64>,
    /// The direction of the branch in the unknowns, of length one in the sizes of the step to here.
    pub tangent: DVector<f64>,
    /// The sign of the determinant of the bordered equations: it changes where branches cross, and
    /// not at a fold.
    pub orientation: f64,
    /// The data of the motion that the caller keeps.
    pub kept: Kept,
}

impl<Kept> OrbitPoint<Kept> {
    /// The parameter.
    pub fn parameter(&self) -> f64 {
        self.unknowns[self.unknowns.len() - 1]
    }

    /// The change of the parameter along the branch: its sign changes at a fold.
    pub fn parameter_slope(&self) -> f64 {
        self.tangent[self.tangent.len() - 1]
    }

    /// The state at the beginning of the period.
    pub fn start(&self) -> &[f64] {
        &self.unknowns.as_slice()[..self.monodromy.nrows()]
    }

    /// Reverses the direction in which the branch is passed.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self { tangent: -self.tangent, orientation: -self.orientation, ..self }
    }
}

/// The reason why a branch ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OrbitBranchEnd {
    /// The end of the range.
    Range,
    /// The branch has come back to its first orbit.
    Closed,
    /// The branch has come back to another of its orbits, and would go round once more.
    Joined,
    /// No step leads on, however small.
    Lost,
    /// The largest number of points was reached.
    Points,
    /// The caller wants no orbits like the next one.
    Refused,
    /// The computation was interrupted.
    Interrupted,
}

/// Range, step size and limits of a branch.
#[derive(Clone, Copy, Debug)]
pub struct OrbitBranchLimits {
    /// The range of the parameter.
    pub range: [f64; 2],
    /// The longest step, as a fraction of the sizes.
    pub longest: f64,
    /// Largest number of points in one direction.
    pub most: usize,
    /// The interrupt, tested before each step.
    pub interrupt: Interrupt,
}

/// The equations of the orbits of a branch.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::interrupt::Interrupt;
/// use lindstedt::numeric::orbit_branch::{OrbitBranchEnd, OrbitBranchLimits, OrbitEquations, PeriodImage};
/// use nalgebra::{DMatrix, DVector};
///
/// // x' = -x + p + cos t over 2 pi: x(0) = p + 1/2, and the multiplier is exp(-2 pi).
/// let vector = |values: &[f64]| DVector::from_column_slice(values);
/// let decay = (-std::f64::consts::TAU).exp();
/// let map = |start: &DVector<f64>, p: f64| {
///     let steady = p + 0.5;
///     Some(PeriodImage {
///         end: vector(&[steady + decay * (start[0] - steady)]),
///         by_start: DMatrix::from_element(1, 1, decay),
///         by_parameter: vector(&[1.0 - decay]),
///         path: (),
///     })
/// };
/// let limits = OrbitBranchLimits { range: [0.0, 1.0], longest: 0.1, most: 100, interrupt: Interrupt::default() };
/// let equations = OrbitEquations {
///     map: &map,
///     smooth: true,
///     accuracy: 4e-15,
///     rounding: 1e-9,
///     keep: &|_, _| (),
///     sizes: &|_| vector(&[1.0, 1.0]),
/// };
/// let first = equations.orbit_at(&vector(&[0.3]), 0.5, &vector(&[1.0, 1.0])).ok_or("none")?;
/// let (points, ends) = equations.branch_through(first, &limits, &|_| false);
/// assert_eq!(ends, [OrbitBranchEnd::Range; 2]);
/// let ends = [(0, [0.5, 0.0]), (points.len() - 1, [1.5, 1.0])];
/// assert!(ends.iter().all(|(index, exact)| (&points[*index].unknowns - vector(exact)).norm() < 1e-9));
/// # Ok::<(), &str>(())
/// ```
pub struct OrbitEquations<'a, Path, Kept> {
    /// The motion over a period from a state with the parameter; `None` if it cannot be followed.
    /// Time is counted in the phase of the drive if the period depends on the parameter.
    pub map: &'a PeriodMap<'a, Path>,
    /// Whether the derivatives of the map change no faster than the map, so that those a last small
    /// step beside an orbit are its own; otherwise they are computed once more on the orbit.
    pub smooth: bool,
    /// Relative accuracy of the map: a step of Newton's method that is no longer changes nothing.
    pub accuracy: f64,
    /// The miss of the map, over its steepest slope, up to which steps of Newton's method that no longer shrink are
    /// rounding: beside a corner steps go from one side to the other and back, as small and never an orbit.
    pub rounding: f64,
    /// The data that are kept of an orbit with these unknowns.
    pub keep: &'a dyn Fn(&DVector<f64>, &PeriodImage<Path>) -> Kept,
    /// The positive sizes in which changes of the unknowns are measured near an orbit.
    pub sizes: &'a dyn Fn(&OrbitPoint<Kept>) -> DVector<f64>,
}

/// The map of a period, of the state at its beginning and the parameter.
pub type PeriodMap<'a, Path> = dyn Fn(&DVector<f64>, f64) -> Option<PeriodImage<Path>> + 'a;

impl<Path, Kept: Clone> OrbitEquations<'_, Path, Kept> {
    /// The motion of a period.
    fn image(&self, unknowns: &DVector<f64>) -> Option<PeriodImage<Path>> {
        let states = unknowns.len() - 1;
        (self.map)(&unknowns.rows(0, states).into_owned(), unknowns[states])
    }

    /// The bordered Jacobian in these sizes, and the residual of all its rows but the last.
    fn bordered(
        image: &PeriodImage<Path>,
        unknowns: &DVector<f64>,
        row: &DVector<f64>,
        sizes: &DVector<f64>,
    ) -> (DMatrix<f64>, DVector<f64>) {
        let (states, count) = (image.end.len(), unknowns.len());
        let mut jacobian = DMatrix::zeros(count - 1, count);
        let mut missed = DVector::zeros(count);
        for i in 0..states {
            missed[i] = (image.end[i] - unknowns[i]) / sizes[i];
            for j in 0..states {
                let own = if i == j { 1.0 } else { 0.0 };
                jacobian[(i, j)] = (image.by_start[(i, j)] - own) * sizes[j] / sizes[i];
            }
            jacobian[(i, count - 1)] = image.by_parameter[i] * sizes[count - 1] / sizes[i];
        }
        (continuation::bordered(&jacobian, row), missed)
    }

    /// Newton's method from a guess at right angles to a direction, which has length one in these
    /// sizes: the orbit, its tangent oriented like the direction, and the number of periods that
    /// were followed. `None` if it does not converge.
    fn corrected(
        &self,
        guess: &DVector<f64>,
        direction: &DVector<f64>,
        sizes: &DVector<f64>,
    ) -> Option<(OrbitPoint<Kept>, usize)> {
        const MOST: usize = 12;
        /// Length of a step below which Newton's method has converged; for a smooth map the next one
        /// would be its square.
        const CONVERGED: f64 = 1e-10;
        const NEXT_IS_ROUNDING: f64 = 1e-8;
        /// Length below which steps that no longer shrink are rounding, which is magnified near
        /// folds.
        const ROUNDING: f64 = 1e-6;
        let mut unknowns = guess.clone();
        let mut before = f64::INFINITY;
        for periods in 1..=MOST {
            let image = self.image(&unknowns)?;
            let (matrix, mut missed) = Self::bordered(&image, &unknowns, direction, sizes);
            let away = (&unknowns - guess).component_div(sizes);
            let by_rounding = self.rounding * (1.0 + matrix.amax());
            let is_rounding = missed.amax() <= by_rounding;
            missed[unknowns.len() - 1] = direction.dot(&away);
            let factors = matrix.lu();
            let step = factors.solve(&missed)?;
            let moved = step.norm();
            if !moved.is_finite() {
                return None;
            }
            if self.smooth && moved <= NEXT_IS_ROUNDING {
                unknowns -= step.component_mul(sizes);
                return self.point(unknowns, &image, &factors, sizes).map(|point| (point, periods));
            }
            let has_stalled = is_rounding && moved <= ROUNDING && moved >= 0.5 * before;
            if moved > CONVERGED && !has_stalled {
                unknowns -= step.component_mul(sizes);
                before = moved;
                continue;
            }
            // The derivatives are those of the orbit itself: beside a grazing one they change within
            // less than the last step.
            unknowns -= step.component_mul(sizes);
            let (image, factors) = match moved <= self.accuracy {
                true => (image, factors),
                false => {
                    let image = self.image(&unknowns)?;
                    let (matrix, _) = Self::bordered(&image, &unknowns, direction, sizes);
                    (image, matrix.lu())
                }
            };
            return self.point(unknowns, &image, &factors, sizes).map(|point| (point, periods));
        }
        None
    }

    /// The orbit with these unknowns, of this image and these bordered equations.
    fn point(
        &self,
        unknowns: DVector<f64>,
        image: &PeriodImage<Path>,
        factors: &LU<f64, Dyn, Dyn>,
        sizes: &DVector<f64>,
    ) -> Option<OrbitPoint<Kept>> {
        let tangent = tangent(factors)?;
        let length = tangent.norm();
        (length > 0.0 && length.is_finite()).then(|| OrbitPoint {
            kept: (self.keep)(&unknowns, image),
            monodromy: image.by_start.clone(),
            tangent: (tangent / length).component_mul(sizes),
            orientation: sign_of_determinant(factors),
            unknowns,
        })
    }

    /// The orbit at a parameter near a state; its tangent leads to larger parameters. `None` if Newton's method does not converge.
    pub fn orbit_at(
        &self,
        guess: &DVector<f64>,
        parameter: f64,
        sizes: &DVector<f64>,
    ) -> Option<OrbitPoint<Kept>> {
        let mut direction = DVector::zeros(guess.len() + 1);
        direction[guess.len()] = 1.0;
        let guess = guess.clone().push(parameter);
        self.corrected(&guess, &direction, sizes).map(|(point, _)| point)
    }

    /// The orbit near a guess of all unknowns, at right angles to a direction, which has length one
    /// in these sizes. `None` if Newton's method does not converge.
    pub fn orbit_along(
        &self,
        guess: &DVector<f64>,
        direction: &DVector<f64>,
        sizes: &DVector<f64>,
    ) -> Option<OrbitPoint<Kept>> {
        self.corrected(guess, direction, sizes).map(|(point, _)| point)
    }

    /// The orbit between two of a branch, at this fraction of the way.
    pub fn between(
        &self,
        from: &OrbitPoint<Kept>,
        to: &OrbitPoint<Kept>,
        part: f64,
    ) -> Option<OrbitPoint<Kept>> {
        self.between_from(
            [from, to],
            part,
            &(&from.unknowns + (&to.unknowns - &from.unknowns) * part),
        )
    }

    /// The orbit between two of a branch, at this fraction of the way, where the search begins near some
    /// unknowns.
    pub fn between_from(
        &self,
        [from, to]: [&OrbitPoint<Kept>; 2],
        part: f64,
        near: &DVector<f64>,
    ) -> Option<OrbitPoint<Kept>> {
        let sizes = (self.sizes)(from);
        let way = &to.unknowns - &from.unknowns;
        let direction = way.component_div(&sizes);
        let length = direction.norm();
        if length == 0.0 {
            return Some(from.clone());
        }
        let direction = direction / length;
        // At right angles to the way through the place on it.
        let place = &from.unknowns + way * part;
        let ahead = direction.dot(&(near - place).component_div(&sizes));
        let guess = near - (&direction * ahead).component_mul(&sizes);
        self.corrected(&guess, &direction, &sizes).map(|(point, _)| point)
    }

    /// The orbit after the last of these at this distance, and the number of periods that were
    /// followed; `None` if Newton's method does not converge, or leads far from the tangent.
    ///
    /// The guess continues the polynomial through the last orbits with their tangents, see [`predicted`]:
    /// through two of them where the branch may have corners.
    fn next(&self, points: &[OrbitPoint<Kept>], length: f64) -> Option<(OrbitPoint<Kept>, usize)> {
        /// Cosine of the angle between tangents beyond which a step was too long.
        const SHARPEST: f64 = 0.94;
        const FARTHEST: f64 = 1.5;
        /// Ratio to the length of the distance from the guess up to which an orbit beyond a change of the
        /// orientation is one of this branch: beside a corner another branch is near, where it is the other one.
        const ASIDE: f64 = 0.1;
        let here = points.last()?;
        let sizes = (self.sizes)(here);
        let along = |point: &OrbitPoint<Kept>| point.tangent.component_div(&sizes).normalize();
        let tangent = along(here);
        let ahead = predicted(points, &sizes, &tangent, length, if self.smooth { 4 } else { 2 });
        let guess = &here.unknowns + ahead.component_mul(&sizes);
        self.corrected(&guess, &tangent, &sizes).filter(|(point, _)| {
            let moved = (&point.unknowns - &here.unknowns).component_div(&sizes).norm();
            let aside = (&point.unknowns - &guess).component_div(&sizes).norm();
            let is_same =
                self.smooth || point.orientation == here.orientation || aside <= ASIDE * length;
            is_same && along(point).dot(&tangent) > SHARPEST && moved < FARTHEST * length
        })
    }

    /// The branch through an orbit, both ways, in the order of its tangents, and the reasons why it
    /// ends before the first point and behind the last. It goes no further than to the orbit before
    /// one that is `refused`.
    pub fn branch_through(
        &self,
        first: OrbitPoint<Kept>,
        limits: &OrbitBranchLimits,
        refused: &dyn Fn(&OrbitPoint<Kept>) -> bool,
    ) -> (Vec<OrbitPoint<Kept>>, [OrbitBranchEnd; 2]) {
        let (mut behind, end) = self.follow(first.clone(), limits, refused);
        if end == OrbitBranchEnd::Closed {
            return (behind, [end; 2]);
        }
        let (before, first_end) = self.follow(first.reversed(), limits, refused);
        let before = before.into_iter().skip(1).rev().map(OrbitPoint::reversed);
        let mut points: Vec<_> = before.collect();
        points.append(&mut behind);
        (points, [first_end, end])
    }

    /// The orbits from the first in the direction of its tangent, and the reason why they end.
    pub fn follow(
        &self,
        first: OrbitPoint<Kept>,
        limits: &OrbitBranchLimits,
        refused: &dyn Fn(&OrbitPoint<Kept>) -> bool,
    ) -> (Vec<OrbitPoint<Kept>>, OrbitBranchEnd) {
        const FIRST: f64 = 0.2;
        // A smooth branch turns in no less than this; one by contacts may.
        let shortest = if self.smooth { 1e-6 } else { 1e-9 };
        /// Numbers of periods per point up to which the next step is longer, and from which on it
        /// is shorter.
        const FEW: usize = 4;
        const MANY: usize = 7;
        const LEAST_TO_CLOSE: usize = 9;
        let [low, high] = limits.range;
        let step = |points: &[OrbitPoint<Kept>], length: &mut f64| {
            use ContinuationStep::{Ended, Taken, TooLong};
            if limits.interrupt.is_requested() {
                return Ended(None, OrbitBranchEnd::Interrupted);
            }
            if points.len() >= limits.most {
                return Ended(None, OrbitBranchEnd::Points);
            }
            let here = &points[points.len() - 1];
            let found = self.next(points, *length);
            let Some((point, periods)) = found else {
                if 0.5 * *length >= shortest {
                    return TooLong;
                }
                let beyond = if self.smooth { None } else { self.around_corner(here, limits) };
                let Some((point, gone)) = beyond else {
                    return Ended(None, OrbitBranchEnd::Lost);
                };
                *length = gone;
                return Taken(point, 1.0);
            };
            let bound = point.parameter().clamp(low, high);
            if bound != point.parameter() {
                return self.at_bound(here, &point, bound);
            }
            if refused(&point) {
                return Ended(None, OrbitBranchEnd::Refused);
            }
            let sizes = (self.sizes)(here);
            let scaled = |point: &OrbitPoint<Kept>| point.unknowns.component_div(&sizes);
            let [target, from, to] = [&points[0], here, &point].map(scaled);
            let same_way = points[0].tangent.component_div(&sizes).dot(&(&to - &from)) > 0.0;
            if points.len() >= LEAST_TO_CLOSE && same_way && passes(&target, &from, &to) {
                return Ended(Some(points[0].clone()), OrbitBranchEnd::Closed);
            }
            if self.goes_round(&points[..points.len().saturating_sub(LEAST_TO_CLOSE)], here, &point)
            {
                return Ended(Some(point), OrbitBranchEnd::Joined);
            }
            let ratio = match periods {
                ..=FEW => 1.4,
                _ if periods > MANY => 0.7,
                _ => 1.0,
            };
            Taken(point, ratio)
        };
        continuation::follow(first, FIRST * limits.longest, limits.longest, step)
    }

    /// Whether the way from one orbit to the next passes one of these, which are known, as the branch
    /// passed it then: where a branch has jumped to another one at a sharp crossing, it goes round
    /// without coming back to its start. Costs a comparison of numbers for each known orbit.
    fn goes_round(
        &self,
        known: &[OrbitPoint<Kept>],
        here: &OrbitPoint<Kept>,
        next: &OrbitPoint<Kept>,
    ) -> bool {
        /// Ratio to the step of the distance below which two orbits are one.
        const SAME: f64 = 1e-3;
        let sizes = (self.sizes)(here);
        let from = here.unknowns.component_div(&sizes);
        let way = next.unknowns.component_div(&sizes) - &from;
        let length = way.norm();
        let last = sizes.len() - 1;
        let is_near = |point: &&OrbitPoint<Kept>| {
            let beyond = (point.unknowns[last] / sizes[last] - from[last]) / length;
            (-0.1..=1.1).contains(&(beyond * way[last].signum()))
        };
        known.iter().filter(is_near).any(|point| {
            let target = point.unknowns.component_div(&sizes);
            let along = (&target - &from).dot(&way) / (length * length);
            let forward = point.tangent.component_div(&sizes).dot(&way) > 0.0;
            if !forward || !passes(&target, &from, &(&from + &way)) {
                return false;
            }
            // The orbit of the branch at right angles to the way through the known one.
            let guess = &here.unknowns + (&next.unknowns - &here.unknowns) * along;
            let found = self.corrected(&guess, &(&way / length), &sizes);
            found.is_some_and(|(found, _)| {
                (&found.unknowns - &point.unknowns).component_div(&sizes).norm() < SAME * length
            })
        })
    }

    /// The orbit beyond a corner of the branch at this one, and its distance: where an orbit begins
    /// to touch a stiff stop the branch turns within less than the last digits of its unknowns.
    ///
    /// A little way ahead the derivatives are those of the orbits beyond, though no orbit is there:
    /// in their direction the touch does not change. The branch goes on that way on which the
    /// orientation stays what it is, as it would on a round corner. Where two stops are touched at
    /// once, branches cross in the corner: those on which only one of them is touched are found a
    /// little aside, and if the orientation stays on none of them, the branch goes on where it
    /// changes.
    fn around_corner(
        &self,
        here: &OrbitPoint<Kept>,
        limits: &OrbitBranchLimits,
    ) -> Option<(OrbitPoint<Kept>, f64)> {
        const LENGTHS: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5];
        /// Ratio to the length of the distance between the orbit and the branch on this side, below
        /// which it lies on that.
        const ASIDE: f64 = 0.05;
        /// Part of a unit vector by which the way ahead is turned aside.
        const TURNED: f64 = 0.5;
        let sizes = (self.sizes)(here);
        let tangent = here.tangent.component_div(&sizes).normalize();
        let beyond = |length: f64, ahead: &DVector<f64>, keeps: bool| {
            let there = &here.unknowns + (ahead * length).component_mul(&sizes);
            let image = self.image(&there)?;
            let (matrix, _) = Self::bordered(&image, &there, &tangent, &sizes);
            let rows = matrix.rows(0, matrix.nrows() - 1);
            let along = least_changed(&(rows.transpose() * rows), None)?;
            [1.0, -1.0].into_iter().find_map(|sign| {
                let direction = &along * sign;
                let guess = &here.unknowns + (&direction * length).component_mul(&sizes);
                let (point, _) = self.corrected(&guess, &direction, &sizes)?;
                let way = (&point.unknowns - &here.unknowns).component_div(&sizes);
                let aside = (&way - &tangent * way.dot(&tangent)).norm();
                let [low, high] = limits.range;
                let is_beyond = (!keeps || point.orientation == here.orientation)
                    && (0.5 * length..1.5 * length).contains(&way.norm())
                    && aside > ASIDE * length
                    && (low..=high).contains(&point.parameter());
                is_beyond.then_some((point, length))
            })
        };
        let states = here.unknowns.len() - 1;
        let turned = (0..states).flat_map(|state| [TURNED, -TURNED].map(|part| (state, part)));
        let turned = turned.map(|(state, part)| {
            let mut ahead = tangent.clone();
            ahead[state] += part;
            ahead.normalize()
        });
        let ways: Vec<DVector<f64>> = std::iter::once(tangent.clone()).chain(turned).collect();
        let straight = LENGTHS.into_iter().find_map(|length| beyond(length, &tangent, true));
        let aside = |keeps: bool| {
            let all =
                LENGTHS.into_iter().flat_map(|length| ways.iter().map(move |way| (length, way)));
            { all }.find_map(|(length, way)| beyond(length, way, keeps))
        };
        straight.or_else(|| aside(true)).or_else(|| aside(false))
    }

    /// The end of a branch at a bound of the range between an orbit inside and one outside.
    fn at_bound(
        &self,
        inside: &OrbitPoint<Kept>,
        outside: &OrbitPoint<Kept>,
        bound: f64,
    ) -> ContinuationStep<OrbitPoint<Kept>, OrbitBranchEnd> {
        /// Distance, in the sizes, between the orbit at the bound and the line from one to the
        /// other, beyond which it is that of another branch.
        const ASIDE: f64 = 0.03;
        /// Length of a step short enough to locate the end of the range.
        const SHORT: f64 = 1e-4;
        let sizes = (self.sizes)(inside);
        let count = inside.unknowns.len();
        let way = outside.parameter() - inside.parameter();
        if inside.parameter() == bound {
            return ContinuationStep::Ended(None, OrbitBranchEnd::Range);
        }
        let part = (bound - inside.parameter()) / way;
        let mut guess = &inside.unknowns + (&outside.unknowns - &inside.unknowns) * part;
        guess[count - 1] = bound;
        let mut direction = DVector::zeros(count);
        direction[count - 1] = way.signum();
        let found = self.corrected(&guess, &direction, &sizes).map(|(point, _)| point);
        let found =
            found.filter(|point| (&point.unknowns - &guess).component_div(&sizes).norm() <= ASIDE);
        match found {
            Some(last) => ContinuationStep::Ended(Some(last), OrbitBranchEnd::Range),
            // At a fold beside the bound there is no orbit, or more than one: one near it will do.
            None if way.abs() <= SHORT * sizes[count - 1] => {
                ContinuationStep::Ended(None, OrbitBranchEnd::Range)
            }
            None => ContinuationStep::TooLong,
        }
    }

    /// Orbits beside a crossing of branches, one on either side of the branch on which it was met:
    /// a little way along the second direction in which the equations have solutions.
    pub fn beside_crossing(&self, at: &OrbitPoint<Kept>) -> Vec<OrbitPoint<Kept>> {
        const APART: f64 = 0.02;
        let sizes = (self.sizes)(at);
        let Some(image) = self.image(&at.unknowns) else {
            return vec![];
        };
        let tangent = at.tangent.component_div(&sizes).normalize();
        let (matrix, _) = Self::bordered(&image, &at.unknowns, &tangent, &sizes);
        // The direction at right angles to the tangent that the Jacobian shortens most.
        let Some(second) = least_changed(&(matrix.transpose() * &matrix), Some(&tangent)) else {
            return vec![];
        };
        let beside = |sign: f64| {
            let direction = &second * sign;
            let guess = &at.unknowns + (&direction * APART).component_mul(&sizes);
            self.corrected(&guess, &direction, &sizes).map(|(point, _)| point)
        };
        [1.0, -1.0].into_iter().filter_map(beside).collect()
    }
}

/// The eigenvector of least eigenvalue of a symmetric matrix, without its part along a direction.
fn least_changed(square: &DMatrix<f64>, but: Option<&DVector<f64>>) -> Option<DVector<f64>> {
    if !square.iter().all(|value| value.is_finite()) {
        return None;
    }
    let eigen = square.clone().symmetric_eigen();
    let vector = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
    let along = but.map_or(0.0, |but| vector.dot(but));
    Some(but.map_or(vector.clone(), |but| vector - but * along).normalize())
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix4, SVector, Vector4};

    use super::*;
    use crate::numeric::ode::{IntegrationOptions, Point, integrate_first_order};
    use crate::numeric::periodic::by_differences;

    fn vector(values: &[f64]) -> DVector<f64> {
        DVector::from_column_slice(values)
    }

    fn limits(range: [f64; 2], longest: f64) -> OrbitBranchLimits {
        OrbitBranchLimits { range, longest, most: 1000, interrupt: Interrupt::default() }
    }

    /// A map of one state with its derivatives.
    fn scalar(
        map: impl Fn(f64, f64) -> [f64; 3],
    ) -> impl Fn(&DVector<f64>, f64) -> Option<PeriodImage<()>> {
        move |start, parameter| {
            let [end, by_start, by_parameter] = map(start[0], parameter);
            Some(PeriodImage {
                end: vector(&[end]),
                by_start: DMatrix::from_element(1, 1, by_start),
                by_parameter: vector(&[by_parameter]),
                path: (),
            })
        }
    }

    /// y -> y + p - y^2: p = y^2, with a fold at zero and the multiplier 1 - 2 y.
    #[test]
    fn a_branch_goes_through_its_fold() {
        let map = scalar(|y, p| [y + p - y * y, 1.0 - 2.0 * y, 1.0]);
        let equations = OrbitEquations {
            map: &map,
            smooth: false,
            accuracy: 4e-15,
            rounding: 1e-9,
            keep: &|_, _| (),
            sizes: &|_| vector(&[1.0, 1.0]),
        };
        let first = equations.orbit_at(&vector(&[0.6]), 0.5, &vector(&[1.0, 1.0])).expect("one");
        let (points, ends) =
            equations.branch_through(first, &limits([-1.0, 1.0], 0.03), &|_| false);
        assert_eq!(ends, [OrbitBranchEnd::Range; 2]);
        for point in &points {
            let y = point.start()[0];
            assert!((point.parameter() - y * y).abs() < 1e-10, "{point:?}");
            assert!((point.monodromy[(0, 0)] - 1.0 + 2.0 * y).abs() < 1e-14);
        }
        let turns = |pair: &[OrbitPoint<()>]| {
            let [one, other] = pair else { return 0 };
            assert_eq!(one.orientation, other.orientation);
            usize::from(one.parameter_slope() * other.parameter_slope() < 0.0)
        };
        assert_eq!(points.windows(2).map(turns).sum::<usize>(), 1);
        let (low, high) = (points[0].start()[0], points[points.len() - 1].start()[0]);
        assert!((low.max(high) - 1.0).abs() < 1e-9 && (low.min(high) + 1.0).abs() < 1e-9);
    }

    /// (r^2 - 1)(r^2 - 1.01) = 0 with r^2 = y^2 + p^2: two circles closer than a tenth of a step.
    #[test]
    fn a_branch_goes_round_where_it_passes_its_own_orbits_the_same_way() {
        let map = scalar(|y, p| {
            let square = y * y + p * p;
            let slope = 2.0 * square - 2.01;
            let value = (square - 1.0) * (square - 1.01);
            [y + value, 1.0 + 2.0 * y * slope, 2.0 * p * slope]
        });
        let sizes = vector(&[1.0, 1.0]);
        let equations = OrbitEquations {
            map: &map,
            smooth: false,
            accuracy: 4e-15,
            rounding: 1e-9,
            keep: &|_, _| (),
            sizes: &|_| vector(&[1.0, 1.0]),
        };
        let orbit = |square: f64, p: f64| {
            let guess = vector(&[(square - p * p).sqrt()]);
            equations.orbit_at(&guess, p, &sizes).expect("an orbit")
        };
        let known = [orbit(1.0, 0.1)];
        let [here, next] = [0.05, 0.15].map(|p| orbit(1.0, p));
        assert!(equations.goes_round(&known, &here, &next));
        // The other way, further on, and on the other circle.
        assert!(!equations.goes_round(&known, &next, &here));
        assert!(!equations.goes_round(&known, &next, &orbit(1.0, 0.25)));
        let [here, next] = [0.05, 0.15].map(|p| orbit(1.01, p));
        assert!(!equations.goes_round(&known, &here, &next));
    }

    /// y^2 + p^2 = 1: guesses of high order need a period or two.
    #[test]
    fn a_smooth_branch_takes_few_periods() {
        let periods = std::cell::Cell::new(0);
        let map = scalar(|y, p| {
            periods.set(periods.get() + 1);
            [y + y * y + p * p - 1.0, 1.0 + 2.0 * y, 2.0 * p]
        });
        let sizes = vector(&[1.0, 1.0]);
        let equations = OrbitEquations {
            map: &map,
            smooth: true,
            accuracy: 4e-15,
            rounding: 1e-9,
            keep: &|_, _| (),
            sizes: &|_| sizes.clone(),
        };
        let first = equations.orbit_at(&vector(&[0.9]), 0.4, &sizes).expect("an orbit");
        periods.set(0);
        let (points, end) = equations.follow(first, &limits([-2.0, 2.0], 0.05), &|_| false);
        assert!(end == OrbitBranchEnd::Closed && points.len() > 120, "{end:?} {}", points.len());
        assert!(points.iter().all(|point| (point.unknowns.norm() - 1.0).abs() < 1e-12));
        assert!(periods.get() <= points.len() + 15, "{} {}", periods.get(), points.len());
    }

    /// y -> y + p y - y^3: y = 0 crosses p = y^2 at zero.
    #[test]
    fn where_branches_cross_the_orientation_changes_and_the_other_one_begins() {
        let map = scalar(|y, p| [y + p * y - y * y * y, 1.0 + p - 3.0 * y * y, y]);
        let equations = OrbitEquations {
            map: &map,
            smooth: false,
            accuracy: 4e-15,
            rounding: 1e-9,
            keep: &|_, _| (),
            sizes: &|_| vector(&[1.0, 1.0]),
        };
        let first = equations.orbit_at(&vector(&[0.0]), -0.51, &vector(&[1.0, 1.0])).expect("one");
        let (points, _) = equations.branch_through(first, &limits([-1.0, 1.0], 0.03), &|_| false);
        let crossed = points.windows(2).find(|pair| pair[0].orientation != pair[1].orientation);
        let [before, behind] = crossed.expect("a crossing") else { panic!() };
        assert!(before.parameter() < 0.0 && behind.parameter() > 0.0);
        let part = -before.parameter() / (behind.parameter() - before.parameter());
        let at = equations.between(before, behind, part * (1.0 + 1e-9)).expect("an orbit");
        let beside = equations.beside_crossing(&at);
        assert_eq!(beside.len(), 2);
        for point in beside {
            let y = point.start()[0];
            assert!(y.abs() > 0.01 && (point.parameter() - y * y).abs() < 1e-10, "{point:?}");
        }
    }

    /// `x'' + D x' + K x = (cos theta, 0)` with theta = omega t: the amplitudes of two coupled
    /// oscillators in closed form, by the map `y_s + exp(2 pi A/omega) (y - y_s)`.
    #[test]
    fn two_coupled_oscillators_follow_their_response_in_closed_form() {
        let a = Matrix4::new(
            0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, -3.0, 1.0, -0.3, 0.1, 1.0, -2.0, 0.1, -0.2,
        );
        // y = c cos + s sin with -omega c = A s and omega s = A c + b: (A^2 + omega^2) c = -A b.
        let steady = |omega: f64| {
            let force = Vector4::new(0.0, 0.0, 1.0, 0.0);
            let matrix = a * a + Matrix4::identity() * (omega * omega);
            matrix.lu().solve(&(-(a * force))).expect("off resonance")
        };
        let grown = |omega: f64| (a * (std::f64::consts::TAU / omega)).exp();
        let end = |y: &Vector4<f64>, omega: f64| {
            let steady = steady(omega);
            steady + grown(omega) * (y - steady)
        };
        let map = |start: &DVector<f64>, omega: f64| {
            const STEP: f64 = 1e-5;
            let y = Vector4::from_column_slice(start.as_slice());
            let slope = (end(&y, omega + STEP) - end(&y, omega - STEP)) / (2.0 * STEP);
            Some(PeriodImage {
                end: DVector::from_column_slice(end(&y, omega).as_slice()),
                by_start: DMatrix::from_column_slice(4, 4, grown(omega).as_slice()),
                by_parameter: DVector::from_column_slice(slope.as_slice()),
                path: (),
            })
        };
        let sizes = DVector::from_element(5, 1.0);
        let equations = OrbitEquations {
            map: &map,
            smooth: false,
            accuracy: 4e-15,
            rounding: 1e-9,
            keep: &|_, _| (),
            sizes: &|_| sizes.clone(),
        };
        let first = equations.orbit_at(&DVector::zeros(4), 1.0, &sizes).expect("an orbit");
        let limits = limits([0.5, 3.0], 0.03);
        let (points, ends) = equations.branch_through(first, &limits, &|_| false);
        assert!(ends == [OrbitBranchEnd::Range; 2] && points.len() > 80);
        for point in &points {
            let exact = steady(point.parameter());
            let apart = point.start().iter().zip(exact.iter()).map(|(one, two)| (one - two).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-9, "{point:?} {exact}");
        }
    }

    /// Van der Pol's limit cycles, whose period is an unknown; at mu = 1 it is 6.6632868593
    /// (M. Urabe, *IRE Trans. Circuit Theory* 7 (1960) 382).
    #[test]
    fn limit_cycles_are_followed_with_their_period() {
        let rates = |[x, v]: [f64; 2], mu: f64| [v, mu * (1.0 - x * x) * v - x];
        let follow = |start: [f64; 2], period: f64, mu: f64| {
            let in_time = |_: f64, y: &[f64; 2], out: &mut [f64; 2]| *out = rates(*y, mu);
            let options = IntegrationOptions::with_tolerance(1e-12);
            let begin = Point { t: 0.0, y: start };
            let path = integrate_first_order(in_time, begin, period, &[], &options).ok()?;
            Some((path.end().y, ()))
        };
        // The orbit begins where x' = 0, which the map of the period checks.
        let map = |start: &DVector<f64>, mu: f64| {
            const STEP: f64 = 1e-5;
            let (period, start) = (start[2], [start[0], start[1]]);
            let (end, by_start, ()) =
                by_differences(start, [1.0; 2], |start| follow(start, period, mu))?;
            let beside = |step: f64| Some(SVector::from(follow(start, period, mu + step)?.0));
            let by_parameter = (beside(STEP)? - beside(-STEP)?) / (2.0 * STEP);
            let flow = rates(end, mu);
            let [[a, c], [b, d]] =
                [0, 1].map(|column| [by_start[(0, column)], by_start[(1, column)]]);
            Some(PeriodImage {
                end: vector(&[end[0], end[1], period + start[1]]),
                by_start: DMatrix::from_row_slice(
                    3,
                    3,
                    &[a, b, flow[0], c, d, flow[1], 0.0, 1.0, 1.0],
                ),
                by_parameter: vector(&[by_parameter[0], by_parameter[1], 0.0]),
                path: (),
            })
        };
        let sizes = vector(&[2.0, 2.0, 6.0, 1.0]);
        let equations = OrbitEquations {
            map: &map,
            smooth: false,
            accuracy: 4e-15,
            rounding: 1e-9,
            keep: &|_, _| (),
            sizes: &|_| sizes.clone(),
        };
        let guess = vector(&[2.0, 0.0, 6.4]);
        let first = equations.orbit_at(&guess, 0.5, &sizes).expect("a cycle");
        let limits = limits([0.3, 1.0], 0.1);
        let (points, ends) = equations.branch_through(first, &limits, &|_| false);
        assert_eq!(ends, [OrbitBranchEnd::Range; 2]);
        let last = &points[points.len() - 1];
        assert_eq!(last.parameter(), 1.0);
        assert!((last.unknowns[2] - 6.663_286_859_3).abs() < 1e-7, "{last:?}");
        // One multiplier is 1, along the cycle.
        let away = DMatrix::identity(2, 2) - last.monodromy.view((0, 0), (2, 2));
        assert!(away.determinant().abs() < 1e-6, "{last:?}");
    }
}

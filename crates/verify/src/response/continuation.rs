//! Branches of periodic motions, followed by pseudo-arclength through folds.
//!
//! ```text
//! R(u, p) = 0,   w_u^2 u'.(u - u_0) + w_p^2 p' (p - p_0) = s        [R_u R_p; w_u^2 u'^T  w_p^2 p'] [du; dp] = -[R; 0]
//! ```
//!
//! A step along the tangent gives a guess, and Newton's method on the bordered equations, at right
//! angles to the tangent, returns to the branch (H. B. Keller, in *Applications of Bifurcation
//! Theory*, Academic Press 1977; R. Seydel, *Practical Bifurcation and Stability Analysis*,
//! Springer 2010, chapter 4). Coefficients are scaled by the size of the motion at the beginning of
//! the step, the parameter by the length of its range. In: a balance, a point on the branch. Out:
//! the points of the whole branch within the range, both ways, with their tangents.

use nalgebra::{DVector, Dyn, LU};

use super::balance::DrivenBalance;
use super::hopf;
use super::stability::TrueMotion;
use crate::interrupt::Interrupt;
use crate::numeric::balance::{CONVERGED, Linearised};
use crate::numeric::continuation::ContinuationStep::{Ended, Taken, TooLong};
use crate::numeric::continuation::{bordered, follow, passes, sign_of_determinant, tangent};

/// A point of a branch.
#[derive(Clone, Debug)]
pub struct BranchNode {
    /// The coefficients of the motion.
    pub coefficients: DVector<f64>,
    /// The parameter.
    pub parameter: f64,
    /// The direction of the branch, of length one in the weights of the step to here.
    pub tangent: DVector<f64>,
    /// The sign of the determinant of the bordered equations: it changes where branches cross, and
    /// not at a fold.
    pub orientation: f64,
    /// The true motion, if the point came from shooting because the motion sticks, or has stuck.
    pub truth: Option<TrueMotion>,
}

impl BranchNode {
    /// Fraction, from zero to one, of the way to the next node at which the parameter has this
    /// value; `None` if it lies outside.
    pub fn part_of_way(&self, next: &Self, parameter: f64) -> Option<f64> {
        let way = next.parameter - self.parameter;
        let part = if way == 0.0 { 0.0 } else { (parameter - self.parameter) / way };
        (-1e-9..=1.0 + 1e-9).contains(&part).then_some(part)
    }

    /// Position and velocity at phase zero.
    pub fn begins(&self, balance: &DrivenBalance) -> [f64; 2] {
        self.truth.map_or_else(
            || balance.phase_point_at(&self.coefficients, self.parameter, 0.0),
            |truth| truth.start,
        )
    }

    /// The way to another point of the branch, in the unknowns of the tangent.
    pub(super) fn way_to(&self, other: &Self) -> DVector<f64> {
        let unknowns = |node: &Self| match node.truth {
            Some(TrueMotion { start: [x, v], .. }) if node.tangent.len() == 3 => {
                DVector::from_vec(vec![x, v, node.parameter])
            }
            _ => stacked(&node.coefficients, node.parameter),
        };
        unknowns(other) - unknowns(self)
    }

    /// dp along the branch: its sign changes at a fold.
    pub fn parameter_slope(&self) -> f64 {
        self.tangent[self.tangent.len() - 1]
    }
}

/// The reason why a branch ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BranchEnd {
    /// The end of the range.
    Range,
    /// A branch point: beyond it lie the motions of the other branch itself, with another phase or
    /// mirrored.
    Crossing,
    /// The branch has come back to its start.
    Closed,
    /// The amplitude grows without bound.
    Unbounded,
    /// No step leads on, however small.
    Lost,
    /// An impact falls on the beginning of a period, where the start of the motion jumps.
    ImpactAtStart,
    /// The motion touches a wall, and a motion with an impact less or more begins.
    Grazing,
    /// The largest number of points was reached.
    Points,
    /// The harmonics that are kept do not suffice for the motions beyond.
    Harmonics,
    /// The motion is at rest all the time: dry friction balances the drive.
    Held,
    /// The amplitude has reached zero: a Hopf point, at which self-excited motions begin.
    Rest,
    /// Its period grows without bound: a self-excited motion approaches an equilibrium, as at a
    /// homoclinic orbit.
    Slow,
    /// Disturbances grow ten thousandfold in a period: a self-excited motion passes slowly by an
    /// equilibrium, as near a homoclinic orbit, or along what repels it.
    Sensitive,
    /// The computation was interrupted.
    Interrupted,
}

impl DrivenBalance<'_> {
    /// A point of a branch, and its images: shifted by drive periods, and mirrored half a drive period
    /// later. An image is a motion of the same equation, mirrored ones where the forces are odd.
    fn images(&self, node: &BranchNode) -> Vec<BranchNode> {
        if self.driven.self_excited {
            return vec![node.clone()];
        }
        let half = std::f64::consts::PI / self.driven.periods as f64;
        let image = |halves: usize| {
            let sign = if halves % 2 == 1 { -1.0 } else { 1.0 };
            let image = |whole: &DVector<f64>| {
                let mut image = self.core.later(whole, half * halves as f64) * sign;
                // The parameter is the same.
                image.rows_mut(self.core.size(), whole.len() - self.core.size()).scale_mut(sign);
                image
            };
            BranchNode {
                coefficients: image(&node.coefficients),
                tangent: image(&node.tangent),
                ..node.clone()
            }
        };
        (0..2 * self.driven.periods).map(image).collect()
    }
}

/// The points of a branch in order, and the reasons why it ends.
#[derive(Clone, Debug)]
pub struct BranchPath {
    /// The points.
    pub nodes: Vec<BranchNode>,
    /// The reason why it ends before the first point, and behind the last.
    pub ends: [BranchEnd; 2],
    /// Whether its mirror image, -x half a period of the drive later, is another branch.
    pub mirrored: bool,
}

/// Range, step size and limits of the continuation of a branch.
#[derive(Clone, Copy, Debug)]
pub struct ContinuationSettings {
    /// The range of the parameter.
    pub range: [f64; 2],
    /// The longest step, as a fraction of the range and of the size of the motion.
    pub longest: f64,
    /// Largest number of points.
    pub most: usize,
    /// Whether it ends where the harmonics do not suffice for the motion.
    pub resolved: bool,
    /// The size of the largest motion known: smaller ones are scaled by a fraction of it.
    pub size: f64,
    /// The size of typical motions: far larger ones count as unbounded.
    pub ordinary: f64,
    /// The interrupt.
    pub interrupt: Interrupt,
}

/// Weights of the norm in which step lengths are measured.
#[derive(Clone, Copy, Debug)]
struct Weights {
    coefficients: f64,
    parameter: f64,
    /// The index and the weight of the frequency, if it is an unknown.
    frequency: Option<(usize, f64)>,
}

impl Weights {
    /// The weight of an unknown, of which there are `size`, or of the parameter, which follows
    /// them.
    fn weight(&self, index: usize, size: usize) -> f64 {
        match self.frequency {
            Some((place, weight)) if place == index => weight,
            _ if index < size => self.coefficients,
            _ => self.parameter,
        }
    }

    fn dot(&self, one: &DVector<f64>, other: &DVector<f64>) -> f64 {
        let size = one.len() - 1;
        (0..one.len())
            .map(|index| self.weight(index, size).powi(2) * one[index] * other[index])
            .sum()
    }

    fn norm(&self, vector: &DVector<f64>) -> f64 {
        self.dot(vector, vector).sqrt()
    }

    fn scaled(&self, vector: &DVector<f64>) -> DVector<f64> {
        vector.map_with_location(|index, _, part| self.weight(index, vector.len() - 1) * part)
    }

    /// A point with its tangent, oriented in this direction.
    fn node(
        &self,
        balance: &DrivenBalance,
        point: DVector<f64>,
        direction: &DVector<f64>,
    ) -> Option<BranchNode> {
        let jacobian = linearised(balance, &point)?.jacobian;
        self.node_of(&bordered(&jacobian, &self.row(direction)).lu(), point)
    }

    /// A point with its tangent, from the factors of the bordered equations there. The sign of
    /// their determinant does not depend on the direction in the last row, as long as the tangent
    /// keeps its orientation.
    fn node_of(&self, factors: &LU<f64, Dyn, Dyn>, point: DVector<f64>) -> Option<BranchNode> {
        let tangent = tangent(factors)?;
        let length = self.norm(&tangent);
        let size = point.len() - 1;
        (length > 0.0 && length.is_finite()).then(|| BranchNode {
            coefficients: point.rows(0, size).into_owned(),
            parameter: point[size],
            tangent: tangent / length,
            orientation: sign_of_determinant(factors),
            truth: None,
        })
    }

    /// The last row of the bordered equations: the weighted inner product with this direction.
    fn row(&self, direction: &DVector<f64>) -> DVector<f64> {
        let size = direction.len() - 1;
        DVector::from_fn(size + 1, |index, _| self.weight(index, size).powi(2) * direction[index])
    }
}

/// The equations at coefficients and a parameter that are one vector.
fn linearised(balance: &DrivenBalance, point: &DVector<f64>) -> Option<Linearised> {
    let size = balance.core.size();
    balance.linearised(&point.rows(0, size).into_owned(), point[size])
}

/// Coefficients and parameter as one vector.
fn stacked(coefficients: &DVector<f64>, parameter: f64) -> DVector<f64> {
    coefficients.clone().push(parameter)
}

/// The size of the largest of these motions, or the median if they grow without bound: steps scaled
/// by an enormous size would pass over a resonance.
pub(super) fn largest<const ENDS: usize>(
    balance: &DrivenBalance,
    nodes: &[BranchNode],
    ends: [BranchEnd; ENDS],
) -> f64 {
    let mut sizes: Vec<f64> =
        nodes.iter().map(|node| balance.core.extent(&node.coefficients)).collect();
    sizes.sort_by(f64::total_cmp);
    let place = match ends.contains(&BranchEnd::Unbounded) {
        true => sizes.len() / 2,
        false => sizes.len().saturating_sub(1),
    };
    sizes.get(place).copied().unwrap_or(0.0)
}

impl ContinuationSettings {
    fn weights(&self, balance: &DrivenBalance, coefficients: &DVector<f64>) -> Weights {
        /// The smallest size used as a scale, as a fraction of the largest.
        const SMALLEST: f64 = 0.1;
        let own = balance.core.extent(coefficients).max(1e-3 * coefficients[0].abs());
        let size = own.max(SMALLEST * self.size);
        Weights {
            coefficients: if size > 0.0 { 1.0 / size } else { 1.0 },
            parameter: 1.0 / (self.range[1] - self.range[0]),
            frequency: balance
                .core
                .frequency_place()
                .map(|place| (place, 1.0 / coefficients[place])),
        }
    }

    /// Newton's method at right angles to a direction: the point, its tangent oriented like
    /// `direction`, and the number of iterations.
    fn corrected(
        &self,
        balance: &DrivenBalance,
        guess: &DVector<f64>,
        direction: &DVector<f64>,
        weights: Weights,
    ) -> Option<(BranchNode, usize)> {
        const MOST: usize = 12;
        let row = weights.row(direction);
        let mut point = guess.clone();
        for iterations in 1..=MOST {
            let linear = linearised(balance, &point)?;
            let factors = bordered(&linear.jacobian, &row).lu();
            let step = factors.solve(&linear.residual.push(row.dot(&(&point - guess))))?;
            let moved = weights.norm(&step);
            if !moved.is_finite() {
                return None;
            }
            point -= &step;
            if moved <= CONVERGED {
                // After so short a step the derivatives are those of the solution.
                return Some((weights.node_of(&factors, point)?, iterations));
            }
        }
        None
    }

    /// A point between two of a branch, at this fraction of the way.
    pub fn between(
        &self,
        balance: &DrivenBalance,
        from: &BranchNode,
        to: &BranchNode,
        part: f64,
    ) -> Option<BranchNode> {
        let weights = self.weights(balance, &from.coefficients);
        let (start, end) =
            (stacked(&from.coefficients, from.parameter), stacked(&to.coefficients, to.parameter));
        let way = &end - &start;
        let length = weights.norm(&way);
        if length == 0.0 {
            return Some(from.clone());
        }
        let guess = &start + &way * part;
        self.corrected(balance, &guess, &(way / length), weights).map(|(node, _)| node)
    }

    /// The whole branch through a motion at a parameter.
    pub fn branch_through(
        &self,
        balance: &DrivenBalance,
        coefficients: &DVector<f64>,
        parameter: f64,
    ) -> Option<BranchPath> {
        let mut direction = DVector::zeros(balance.core.size() + 1);
        direction[balance.core.size()] = self.range[1] - self.range[0];
        self.branch_along(balance, coefficients, parameter, &direction)
    }

    /// The whole branch through a motion, its first direction given.
    pub fn branch_along(
        &self,
        balance: &DrivenBalance,
        coefficients: &DVector<f64>,
        parameter: f64,
        direction: &DVector<f64>,
    ) -> Option<BranchPath> {
        let weights = self.weights(balance, coefficients);
        let direction = direction / weights.norm(direction);
        let start = weights.node(balance, stacked(coefficients, parameter), &direction)?;
        let mut backward = start.clone();
        backward.tangent *= -1.0;
        // The direction in the last row of the bordered equations is reversed.
        backward.orientation *= -1.0;
        let (mut nodes, end) = self.follow(balance, start);
        if end == BranchEnd::Closed {
            return Some(BranchPath { nodes, ends: [end, end], mirrored: false });
        }
        let largest = largest(balance, &nodes, [end]).max(self.size);
        let (before, first_end) = Self { size: largest, ..*self }.follow(balance, backward);
        let turned = before.into_iter().skip(1).map(|mut node| {
            node.tangent *= -1.0;
            node.orientation *= -1.0;
            node
        });
        let mut all: Vec<BranchNode> = turned.collect();
        all.reverse();
        all.append(&mut nodes);
        Some(BranchPath { nodes: all, ends: [first_end, end], mirrored: false })
    }

    /// The motions at which a branch that leaves the range re-enters it, if it is followed up to
    /// the bounds `wide`: a resonance whose peak lies outside has two of its branches inside, and
    /// one of them may be hard to find otherwise.
    pub(super) fn reentries(
        &self,
        balance: &DrivenBalance,
        path: &BranchPath,
        wide: [f64; 2],
    ) -> Vec<(DVector<f64>, f64)> {
        /// Largest number of points beyond the range.
        const MOST: usize = 200;
        let outward = |(node, turn): (&BranchNode, f64)| BranchNode {
            tangent: &node.tangent * turn,
            ..node.clone()
        };
        let ends = [
            path.nodes.first().map(|node| (node, -1.0)),
            path.nodes.last().map(|node| (node, 1.0)),
        ];
        let ends = ends.into_iter().zip(path.ends).filter(|(_, end)| *end == BranchEnd::Range);
        let walk = Self { range: wide, most: MOST, ..*self };
        let [low, high] = self.range;
        let back = |pair: &[BranchNode]| {
            let [from, to] = pair else { return None };
            let inside = to.parameter.clamp(low, high);
            let part = from.part_of_way(to, inside)?;
            // A point on the bound itself has not left the range yet.
            let left = from.parameter.clamp(low, high) != from.parameter;
            let guess = &from.coefficients + (&to.coefficients - &from.coefficients) * part;
            let found = left.then(|| balance.solve(&guess, inside)).flatten()?;
            Some((found, inside))
        };
        ends.filter_map(|(end, _)| end.map(outward))
            .flat_map(|start| {
                walk.follow(balance, start).0.windows(2).filter_map(back).collect::<Vec<_>>()
            })
            .collect()
    }

    /// Whether the last harmonics are so large that about as many more would be needed.
    pub(super) fn is_cut_off(&self, balance: &DrivenBalance, coefficients: &DVector<f64>) -> bool {
        /// Largest size of the last quarter of the harmonics, relative to the motion; for a
        /// resolved motion it is negligible.
        const LARGEST: f64 = 0.1;
        self.resolved
            && balance.core.last_harmonics(coefficients)
                > LARGEST * balance.core.extent(coefficients)
    }

    /// The points that follow `start` in the direction of its tangent, and the reason why they end.
    fn follow(&self, balance: &DrivenBalance, start: BranchNode) -> (Vec<BranchNode>, BranchEnd) {
        const FIRST: f64 = 0.2;
        const SHORTEST: f64 = 1e-9;
        /// Length of a step short enough to locate where the harmonics no longer suffice, or the
        /// end of the range.
        const SHORT: f64 = 1e-4;
        const FEW: usize = 3;
        const MANY: usize = 6;
        /// Cosine of the angle between tangents beyond which a step was too long.
        const SHARPEST: f64 = 0.94;
        const ENORMOUS: f64 = 1e4;
        /// Ratio to the highest frequency of a branch below which a motion is too slow for a sum of
        /// harmonics.
        const SLOW: f64 = 0.05;
        let [low, high] = self.range;
        let bound = ENORMOUS * balance.core.extent(&start.coefficients).max(self.ordinary);
        // A branch that goes on to its own image goes through all of them in turn.
        let firsts = balance.images(&start);
        // A self-excited motion near rest may end in a Hopf point.
        let at_rest = |here: &BranchNode, near: f64| match self.rest_beside(balance, here, near) {
            Some(rest) => Ended(Some(rest), BranchEnd::Rest),
            None => Ended(None, BranchEnd::Lost),
        };
        let mut fastest = 0.0_f64;
        let step = |nodes: &[BranchNode], length: &mut f64| {
            let length = *length;
            if self.interrupt.is_requested() {
                return Ended(None, BranchEnd::Interrupted);
            }
            if nodes.len() >= self.most {
                return Ended(None, BranchEnd::Points);
            }
            let here = &nodes[nodes.len() - 1];
            let weights = self.weights(balance, &here.coefficients);
            let tangent = &here.tangent / weights.norm(&here.tangent);
            let start = stacked(&here.coefficients, here.parameter);
            let guess = &start + &tangent * length;
            let found = self.corrected(balance, &guess, &tangent, weights).filter(|(node, _)| {
                let next = &node.tangent / weights.norm(&node.tangent);
                let moved = weights.norm(&(stacked(&node.coefficients, node.parameter) - &start));
                weights.dot(&next, &tangent) > SHARPEST && moved < 1.5 * length
            });
            let Some((node, iterations)) = found else {
                return match 0.5 * length < SHORTEST {
                    // If the damping has a corner at rest, so has the branch.
                    true => at_rest(here, here.parameter),
                    false => TooLong,
                };
            };
            // Ends the branch for this reason unless a shorter step may do better.
            let ends = |end: BranchEnd| match 0.5 * length < SHORT {
                true => Ended(None, end),
                false => TooLong,
            };
            if self.is_cut_off(balance, &node.coefficients) {
                return ends(BranchEnd::Harmonics);
            }
            if node.parameter < low || node.parameter > high {
                // If the end of the range is a resonance of a harmonic, it has no motion, or more
                // than one: a point near it will do.
                return match self.at_bound(balance, here, &node) {
                    Some(last) => Ended(Some(last), BranchEnd::Range),
                    None => ends(BranchEnd::Range),
                };
            }
            if balance.driven.self_excited && here.coefficients[1] * node.coefficients[1] <= 0.0 {
                // Beyond the Hopf point the same motions follow, shifted by half a period.
                let part = here.coefficients[1] / (here.coefficients[1] - node.coefficients[1]);
                return at_rest(here, here.parameter + part * (node.parameter - here.parameter));
            }
            if let Some(place) = balance.core.frequency_place() {
                let own = node.coefficients[place];
                fastest = fastest.max(own);
                if own < SLOW * fastest {
                    return Ended(None, BranchEnd::Slow);
                }
            }
            if balance.core.extent(&node.coefficients) > bound {
                return Ended(None, BranchEnd::Unbounded);
            }
            if nodes.len() > 8 {
                let closes = |first: &&BranchNode| self.has_closed(first, here, &node, weights);
                if let Some(first) = firsts.iter().find(closes) {
                    return Ended(Some(first.clone()), BranchEnd::Closed);
                }
            }
            let ratio = match iterations {
                ..=FEW => 1.4,
                _ if iterations > MANY => 0.7,
                _ => 1.0,
            };
            Taken(node, ratio)
        };
        follow(start, FIRST * self.longest, self.longest, step)
    }

    /// The motion of amplitude zero next to a small one, near this parameter: the Hopf point of a
    /// self-excited motion.
    pub(super) fn rest_beside(
        &self,
        balance: &DrivenBalance,
        here: &BranchNode,
        near: f64,
    ) -> Option<BranchNode> {
        /// Distance, relative to the largest motion and to the range, within which a motion counts
        /// as near.
        const BESIDE: f64 = 0.1;
        let small = BESIDE * self.size.max(self.ordinary);
        if !balance.driven.self_excited || balance.core.extent(&here.coefficients) > small {
            return None;
        }
        let [low, high] = self.range;
        let born =
            hopf::hopf_point_near(balance.driven, here.coefficients[0], near, [small, high - low])?;
        let far = (born.parameter - here.parameter).abs() > BESIDE * (high - low)
            || (born.position - here.coefficients[0]).abs() > small;
        if far || !(low..=high).contains(&born.parameter) {
            return None;
        }
        let mut coefficients = DVector::zeros(balance.core.size());
        coefficients[0] = born.position;
        coefficients[balance.core.frequency_place()?] = born.frequency;
        Some(BranchNode { coefficients, parameter: born.parameter, ..here.clone() })
    }

    /// Whether the step between two points passes the first point of the branch, or an image of it, in its
    /// direction.
    fn has_closed(
        &self,
        first: &BranchNode,
        here: &BranchNode,
        next: &BranchNode,
        weights: Weights,
    ) -> bool {
        let scaled =
            |node: &BranchNode| weights.scaled(&stacked(&node.coefficients, node.parameter));
        let [target, from, to] = [first, here, next].map(scaled);
        weights.scaled(&first.tangent).dot(&(&to - &from)) > 0.0 && passes(&target, &from, &to)
    }

    /// The point at the end of the range between a point inside and one outside.
    fn at_bound(
        &self,
        balance: &DrivenBalance,
        inside: &BranchNode,
        outside: &BranchNode,
    ) -> Option<BranchNode> {
        let [low, high] = self.range;
        let bound = if outside.parameter < low { low } else { high };
        let way = outside.parameter - inside.parameter;
        if bound == inside.parameter {
            return None;
        }
        let part = (bound - inside.parameter) / way;
        let guess = &inside.coefficients + (&outside.coefficients - &inside.coefficients) * part;
        let coefficients = balance.solve(&guess, bound)?;
        let weights = self.weights(balance, &inside.coefficients);
        let jump = weights.norm(&stacked(&(&coefficients - &guess), 0.0));
        if jump > self.longest {
            return None;
        }
        weights.node(balance, stacked(&coefficients, bound), &inside.tangent)
    }

    /// Motions beside a crossing of branches, one on either side: the direction in which the
    /// equations have a second solution, and the motions a little way along it.
    pub fn crossing(&self, balance: &DrivenBalance, at: &BranchNode) -> Vec<BranchNode> {
        const APART: f64 = 0.02;
        let size = balance.core.size();
        let Some(linear) = balance.linearised(&at.coefficients, at.parameter) else {
            return vec![];
        };
        let weights = self.weights(balance, &at.coefficients);
        // In weighted variables, so that right angles are those of the steps.
        let matrix =
            linear.jacobian.map_with_location(|_, j, slope| slope / weights.weight(j, size));
        let square = matrix.transpose() * &matrix;
        let eigen = square.symmetric_eigen();
        let mut order: Vec<usize> = (0..=size).collect();
        order.sort_by(|one, other| eigen.eigenvalues[*one].total_cmp(&eigen.eigenvalues[*other]));
        let scale = |index: usize| weights.weight(index, size);
        let tangent = DVector::from_fn(size + 1, |index, _| at.tangent[index] * scale(index));
        let tangent = &tangent / tangent.norm();
        let candidates = order.iter().take(2).map(|index| {
            let vector = eigen.eigenvectors.column(*index).into_owned();
            let along = vector.dot(&tangent);
            vector - &tangent * along
        });
        let Some(second) = candidates.max_by(|one, other| one.norm().total_cmp(&other.norm()))
        else {
            return vec![];
        };
        let second = &second / second.norm();
        let direction = DVector::from_fn(size + 1, |index, _| second[index] / scale(index));
        let start = stacked(&at.coefficients, at.parameter);
        let found = [1.0, -1.0].map(|sign| {
            let direction = &direction * sign;
            let guess = &start + &direction * APART;
            self.corrected(balance, &guess, &direction, weights).map(|(node, _)| node)
        });
        found.into_iter().flatten().collect()
    }
}

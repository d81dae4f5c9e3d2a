//! Branches of motions across jumps of the force that harmonic balance cannot treat, by the map of
//! a period.
//!
//! ```text
//! P(y; p): position and velocity a period later,   P(y; p) - y = 0        [M - 1  P_p; y'^T  p'] [dy; dp] = -[P - y; 0]
//! ```
//!
//! A sum of waves is smooth and contains no interval of rest, so that harmonic balance fails where
//! sticking begins. The map of a period, followed from event to event ([`jump`](super::jump)), is
//! continuous there, and its derivative M is the product of the variations of the legs and of their
//! saltation matrices; for a motion that sticks one multiplier is zero. Pseudo-arclength
//! continuation uses this map (R. I. Leine and H. Nijmeijer, *Dynamics and Bifurcations of
//! Non-Smooth Mechanical Systems*, Springer 2004, chapter 8). Without a drive the map leads from
//! one maximum of the displacement to the next, and its derivative is the multiplier. In: a
//! periodic motion. Out: the branch through it, each point with the harmonics of the true motion.

use nalgebra::{DVector, Matrix2, Matrix3, Vector3};

use super::balance::DrivenBalance;
use super::branches::{KnownMotion, largest};
use super::continuation::{BranchEnd, BranchNode, BranchPath};
use super::jump::{StopCondition, VariationalMotion, follow};
use super::seeds::{Seed, size_of};
use super::stability::{
    Floquet, MotionGuess, SAMPLES, TOLERANCE, TrueMotion, convergence_test, half_of_peak_to_peak,
    options,
};
use super::{LONGEST_STEP, MOST_BRANCHES, PreparedRequest};
use crate::numeric::continuation::ContinuationStep::{Ended, Taken, TooLong};
use crate::numeric::continuation::{self, passes};

/// Position, velocity and parameter, each divided by its scale.
type ScaledPoint = Vector3<f64>;

/// A periodic motion on a branch.
#[derive(Clone, Debug)]
struct ShootingOrbit {
    at: ScaledPoint,
    tangent: ScaledPoint,
    /// The sign of the determinant of the bordered matrix whose last row is the tangent, which changes
    /// where another branch crosses; zero of a motion that sticks, whose map has a corner.
    orientation: f64,
    course: VariationalMotion,
}

/// The map of a period in scaled variables.
struct PeriodMap<'a> {
    asked: &'a PreparedRequest<'a>,
    /// The scales of position, velocity and parameter.
    sizes: ScaledPoint,
}

impl<'a> PeriodMap<'a> {
    fn new(asked: &'a PreparedRequest<'a>, size: f64, parameter: f64) -> Self {
        let [low, high] = asked.question.range;
        let size = size.max(1e-12);
        Self {
            asked,
            sizes: Vector3::new(size, size * asked.driven.frequency_at(parameter), high - low),
        }
    }

    fn scaled(&self, start: [f64; 2], parameter: f64) -> ScaledPoint {
        Vector3::new(start[0], start[1], parameter).component_div(&self.sizes)
    }

    fn start(&self, at: &ScaledPoint) -> ([f64; 2], f64) {
        let real = at.component_mul(&self.sizes);
        ([real[0], real[1]], real[2])
    }

    /// The motion over a period from this point; `None` if it cannot be followed.
    fn period(&self, at: &ScaledPoint) -> Option<VariationalMotion> {
        /// The longest time in which a motion without drive has to turn back.
        const LONGEST: f64 = 1e3;
        let (start, parameter) = self.start(at);
        let driven = &self.asked.driven;
        let options = options(self.sizes[0].max(start[0].abs()), TOLERANCE);
        if driven.self_excited {
            let mut course =
                follow(driven, [start[0], 0.0], parameter, StopCondition::Turn(LONGEST), &options)?;
            // A displacement along the trajectory does not give another motion: only the position
            // of the start varies, and the velocity at the end is zero.
            let [x, _, by_start, ..] = course.end;
            course.end = [x, 0.0, by_start, 0.0, 0.0, 0.0];
            return course.turned().then_some(course);
        }
        let omega = driven.frequency_at(parameter);
        if omega.is_nan() || omega <= 0.0 {
            return None;
        }
        follow(
            driven,
            start,
            parameter,
            StopCondition::Time(std::f64::consts::TAU / omega),
            &options,
        )
    }

    /// dP/dp, by differences.
    fn by_parameter(&self, at: &ScaledPoint) -> Option<[f64; 2]> {
        const STEP: f64 = 1e-5;
        let [above, below] =
            [STEP, -STEP].map(|step| self.period(&(at + Vector3::new(0.0, 0.0, step))));
        let (above, below) = (above?.end, below?.end);
        Some([0, 1].map(|index| (above[index] - below[index]) / (2.0 * STEP * self.sizes[index])))
    }

    /// The bordered matrix at a motion, with this last row.
    fn bordered(
        &self,
        course: &VariationalMotion,
        by_parameter: [f64; 2],
        row: &ScaledPoint,
    ) -> Matrix3<f64> {
        let [_, _, a, c, b, d] = course.end;
        let ratio = self.sizes[1] / self.sizes[0];
        Matrix3::new(
            a - 1.0,
            b * ratio,
            by_parameter[0],
            c / ratio,
            d - 1.0,
            by_parameter[1],
            row[0],
            row[1],
            row[2],
        )
    }

    /// Newton's method at right angles to a direction: the motion, with its tangent oriented like
    /// the direction.
    fn corrected(&self, guess: &ScaledPoint, direction: &ScaledPoint) -> Option<ShootingOrbit> {
        const MOST: usize = 14;
        const SETTLED: f64 = 1e-9;
        let mut at = *guess;
        let mut by_parameter = self.by_parameter(&at)?;
        let mut settled = convergence_test(SETTLED);
        for iteration in 0..MOST {
            let course = self.period(&at)?;
            let (start, _) = self.start(&at);
            let missed = [0, 1].map(|index| (course.end[index] - start[index]) / self.sizes[index]);
            let matrix = self.bordered(&course, by_parameter, direction);
            let right = Vector3::new(-missed[0], -missed[1], -direction.dot(&(at - guess)));
            let step = matrix.lu().solve(&right)?;
            let moved = step.norm();
            if !moved.is_finite() {
                return None;
            }
            if settled(f64::INFINITY, moved) {
                let by_parameter = self.by_parameter(&at)?;
                let matrix = self.bordered(&course, by_parameter, direction);
                let tangent = matrix.lu().solve(&Vector3::new(0.0, 0.0, 1.0))?;
                let length = tangent.norm();
                let bordered = self.bordered(&course, by_parameter, &tangent);
                let is_smooth = course.stuck() == 0.0 && !self.asked.driven.self_excited;
                return (length > 0.0 && length.is_finite()).then(|| ShootingOrbit {
                    at,
                    tangent: tangent / length,
                    orientation: if is_smooth { bordered.determinant().signum() } else { 0.0 },
                    course,
                });
            }
            at += step;
            if iteration == MOST / 2 {
                by_parameter = self.by_parameter(&at)?;
            }
        }
        None
    }

    /// The motion at this parameter near a start, its tangent toward larger parameters.
    fn shoot(&self, start: [f64; 2], parameter: f64) -> Option<ShootingOrbit> {
        self.corrected(&self.scaled(start, parameter), &Vector3::new(0.0, 0.0, 1.0))
    }

    /// Motions a little way along the other branch through a crossing, one on either side, each with its
    /// tangent away from it: in the direction in which the map has a second null vector, at right angles to
    /// that of the known branch.
    fn crossing(&self, at: &ScaledPoint, tangent: &ScaledPoint) -> Vec<ShootingOrbit> {
        const APART: f64 = 0.02;
        let (Some(course), Some(by_parameter)) = (self.period(at), self.by_parameter(at)) else {
            return vec![];
        };
        let derivatives = self.bordered(&course, by_parameter, &ScaledPoint::zeros());
        // The rank is one here, and what is left of the larger row tells the plane of both branches.
        let rows = [0, 1].map(|index| derivatives.row(index).transpose());
        let [one, other] = rows.map(|row| row.norm());
        let normal = if one > other { rows[0] } else { rows[1] };
        let second = normal.cross(tangent);
        if !(second.norm() > 0.0 && second.norm().is_finite()) {
            return vec![];
        }
        let second = second.normalize();
        let found = [1.0, -1.0].map(|sign| {
            let direction = second * sign;
            self.corrected(&(at + direction * APART), &direction)
        });
        found.into_iter().flatten().collect()
    }

    /// The motions in the direction of the tangent, the first included, and the reason why they
    /// end. `met` tells whether a motion lies on another branch.
    fn walk(
        &self,
        first: ShootingOrbit,
        met: &dyn Fn(&BranchNode) -> bool,
        balance: &DrivenBalance,
    ) -> (Vec<ShootingOrbit>, BranchEnd) {
        const FIRST: f64 = 0.2;
        const SHORTEST: f64 = 1e-7;
        const MOST: usize = 500;
        /// Least cosine of the angle between tangents; it is small because a branch has a corner
        /// where a motion begins to stick.
        const SHARPEST: f64 = 0.5;
        /// Fraction of a period that counts as all of it.
        const ALL: f64 = 1.0 - 1e-9;
        const NEARLY_ALL: f64 = 0.8;
        let bounds = self.asked.question.range.map(|bound| bound / self.sizes[2]);
        let step = |shots: &[ShootingOrbit], length: &mut f64| {
            let length = *length;
            if self.asked.question.interrupt.is_requested() {
                return Ended(None, BranchEnd::Interrupted);
            }
            if shots.len() > MOST {
                return Ended(None, BranchEnd::Points);
            }
            let here = &shots[shots.len() - 1];
            let guess = here.at + here.tangent * length;
            let found = self.corrected(&guess, &here.tangent).filter(|shot| {
                let moved = (shot.at - here.at).norm();
                shot.tangent.dot(&here.tangent) > SHARPEST
                    && moved < 1.5 * length
                    && shot.course.stuck() < ALL
            });
            let Some(shot) = found else {
                return match here.course.stuck() > NEARLY_ALL {
                    _ if 0.5 * length >= SHORTEST => TooLong,
                    true => Ended(None, BranchEnd::Held),
                    false => Ended(None, BranchEnd::Lost),
                };
            };
            if !(bounds[0]..=bounds[1]).contains(&shot.at[2]) {
                let bound = if shot.at[2] < bounds[0] { bounds[0] } else { bounds[1] };
                if (bound - here.at[2]).abs() <= 1e-9 {
                    return Ended(None, BranchEnd::Range);
                }
                let part = (bound - here.at[2]) / (shot.at[2] - here.at[2]);
                let mut guess = here.at + (shot.at - here.at) * part;
                guess[2] = bound;
                let direction = Vector3::new(0.0, 0.0, (shot.at[2] - here.at[2]).signum());
                return Ended(self.corrected(&guess, &direction), BranchEnd::Range);
            }
            if shots.len() > 9 && passes(&shots[0].at, &here.at, &shot.at) {
                return Ended(None, BranchEnd::Closed);
            }
            if shot.course.stuck() == 0.0
                && self.asked.driven.is_balanced()
                && met(&self.node(balance, &shot))
            {
                return Ended(None, BranchEnd::Crossing);
            }
            Taken(shot, 1.4)
        };
        continuation::follow(first, FIRST * LONGEST_STEP, LONGEST_STEP, step)
    }

    /// A point of a branch with the harmonics of the motion.
    fn node(&self, balance: &DrivenBalance, shot: &ShootingOrbit) -> BranchNode {
        let (start, parameter) = self.start(&shot.at);
        let frequency = std::f64::consts::TAU / shot.course.duration();
        let self_excited = self.asked.driven.self_excited;
        let [_, _, a, c, b, d] = shot.course.end;
        let monodromy = match self_excited {
            true => Matrix2::new(a, 0.0, 0.0, 1.0),
            false => Matrix2::new(a, b, c, d),
        };
        let positions = shot.course.positions(SAMPLES);
        let mut tangent = DVector::zeros(balance.core.size() + 1);
        tangent[balance.core.size()] = shot.tangent[2];
        BranchNode {
            coefficients: balance.core.unknowns_of(&[&positions], frequency),
            parameter,
            tangent,
            orientation: shot.orientation,
            truth: Some(TrueMotion::new(
                start,
                frequency,
                Floquet { monodromy, self_excited },
                &positions,
                shot.course.stuck(),
            )),
        }
    }
}

/// Removes the states of rest from a branch, in which friction balances the drive.
fn cut_rest(balance: &DrivenBalance, path: &mut BranchPath, size: f64) {
    const NOTHING: f64 = 1e-5;
    let moves = |node: &BranchNode| balance.core.extent(&node.coefficients) > NOTHING * size;
    let Some(first) = path.nodes.iter().position(moves) else {
        path.nodes.clear();
        return;
    };
    let last = path.nodes.iter().rposition(moves).unwrap_or(first);
    if last + 1 < path.nodes.len() {
        path.nodes.truncate(last + 1);
        path.ends[1] = BranchEnd::Held;
    }
    if first > 0 {
        path.nodes.drain(..first);
        path.ends[0] = BranchEnd::Held;
    }
}

impl PreparedRequest<'_> {
    /// Continues every branch that harmonic balance has lost because the motion begins to stick,
    /// and adds the branches that stick throughout.
    pub(super) fn follow_sticking(
        &self,
        balance: &DrivenBalance,
        seeds: &[Seed],
        paths: &mut Vec<BranchPath>,
        size: f64,
    ) {
        if self.driven.jumps() == 0 {
            return;
        }
        for index in 0..paths.len() {
            for side in 0..2 {
                if paths[index].ends[side] == BranchEnd::Lost {
                    self.follow_on(balance, paths, (index, side), size);
                }
            }
        }
        for path in paths.iter_mut() {
            cut_rest(balance, path, size);
        }
        paths.retain(|path| path.nodes.len() > 1);
        for seed in seeds {
            let Some(start) = seed.start else { continue };
            if paths.len() >= MOST_BRANCHES || self.question.interrupt.is_requested() {
                return;
            }
            let map = PeriodMap::new(
                self,
                half_of_peak_to_peak(&seed.positions).max(0.1 * size),
                seed.parameter,
            );
            let Some(shot) = map.shoot(start, seed.parameter) else {
                continue;
            };
            // An equilibrium is not a motion.
            let own = shot.course.stuck() > 0.0 || !self.driven.is_balanced();
            let moves = shot.course.extent() > 1e-6 * size;
            if own
                && moves
                && !self.was_known(balance, paths, &map.node(balance, &shot))
                && let Some(path) = self.stuck_branch(balance, &map, shot, paths)
            {
                self.keep(balance, self.ended_at_rest(balance, seeds, path), paths);
            }
        }
    }

    /// A branch of self-excited motions completed by its Hopf point, if it has one; motions too
    /// small to be distinguished from rest are removed.
    fn ended_at_rest(
        &self,
        balance: &DrivenBalance,
        seeds: &[Seed],
        mut path: BranchPath,
    ) -> BranchPath {
        /// Ratio to the largest motion below which a motion is small.
        const SMALL: f64 = 1e-3;
        if !self.driven.self_excited {
            return path;
        }
        let largest = largest(balance, &path);
        for side in 0..2 {
            if path.ends[side] != BranchEnd::Lost {
                continue;
            }
            if side == 0 {
                path.nodes.reverse();
            }
            let is_small =
                |node: &BranchNode| balance.core.extent(&node.coefficients) <= SMALL * largest;
            while path.nodes.len() > 2 && path.nodes.last().is_some_and(is_small) {
                path.nodes.pop();
            }
            let walk = self.walk(size_of(seeds), largest);
            let rest =
                path.nodes.last().and_then(|last| walk.rest_beside(balance, last, last.parameter));
            if let Some(rest) = rest {
                path.nodes.push(BranchNode { truth: None, ..rest });
                path.ends[side] = BranchEnd::Rest;
            }
            if side == 0 {
                path.nodes.reverse();
            }
        }
        path
    }

    /// The branch through a motion that sticks.
    fn stuck_branch(
        &self,
        balance: &DrivenBalance,
        map: &PeriodMap,
        shot: ShootingOrbit,
        paths: &[BranchPath],
    ) -> Option<BranchPath> {
        let met = |node: &BranchNode| self.is_met(balance, paths, node);
        let turned = |shot: ShootingOrbit| ShootingOrbit {
            tangent: -shot.tangent,
            orientation: -shot.orientation,
            ..shot
        };
        let (behind, last) = map.walk(shot.clone(), &met, balance);
        let closing = (last == BranchEnd::Closed).then(|| shot.clone());
        let (before, first) = match last {
            BranchEnd::Closed => (vec![], last),
            _ => map.walk(turned(shot), &met, balance),
        };
        let before = before.into_iter().skip(1).rev().map(turned);
        let shots = before.chain(behind).chain(closing);
        let nodes: Vec<BranchNode> = shots.map(|shot| map.node(balance, &shot)).collect();
        (nodes.len() > 1).then_some(BranchPath { nodes, ends: [first, last], mirrored: false })
    }

    /// Follows the branch that crosses one across jumps here, on both sides of it unless one is the image
    /// of the other.
    pub(super) fn follow_stuck_crossing(
        &self,
        balance: &DrivenBalance,
        at: &BranchNode,
        size: f64,
        paths: &mut Vec<BranchPath>,
    ) {
        let Some(truth) = at.truth else { return };
        let size = balance.core.extent(&at.coefficients).max(0.1 * size);
        let map = PeriodMap::new(self, size, at.parameter);
        // The way of this branch, of which the coefficients are linear in position and velocity.
        let way = balance.core.size();
        let (along, slope) = (at.tangent.rows(0, way).into_owned(), at.tangent[way]);
        let aside = balance.phase_point_at(&along, at.parameter, 0.0);
        let tangent = map.scaled(aside, slope);
        for shot in map.crossing(&map.scaled(truth.start, at.parameter), &tangent) {
            let beside = map.node(balance, &shot);
            if self.was_known(balance, paths, &beside) {
                continue;
            }
            let met = |node: &BranchNode| self.is_met(balance, paths, node);
            let (shots, end) = map.walk(shot, &met, balance);
            let outward = shots.iter().map(|shot| map.node(balance, shot));
            let nodes: Vec<BranchNode> = std::iter::once(at.clone()).chain(outward).collect();
            // Near the crossing, where branches turn, and at folds a known motion may not be recognised.
            let known = |quarter: usize| {
                let node = &nodes[quarter * nodes.len() / 4];
                self.was_known(balance, paths, node)
            };
            if !(1..4).any(known) {
                let path = BranchPath { nodes, ends: [BranchEnd::Crossing, end], mirrored: false };
                self.keep(balance, path, paths);
            }
        }
    }

    /// Continues a branch beyond one of its ends.
    fn follow_on(
        &self,
        balance: &DrivenBalance,
        paths: &mut [BranchPath],
        (index, side): (usize, usize),
        size: f64,
    ) {
        /// Number of points at an end that harmonic balance may have computed wrongly.
        const ASTRAY: usize = 40;
        let path = &paths[index];
        let nodes: Vec<&BranchNode> = match side {
            0 => path.nodes.iter().collect(),
            _ => path.nodes.iter().rev().collect(),
        };
        let truth = |node: &BranchNode| Some(self.judged(balance, node).1?.start);
        let good = (0..nodes.len().saturating_sub(1).min(ASTRAY)).find_map(|skipped| {
            Some((skipped, truth(nodes[skipped])?, truth(nodes[skipped + 1])?))
        });
        let Some((skipped, last, inner)) = good else {
            return;
        };
        let [at, beside] = [nodes[skipped], nodes[skipped + 1]];
        let map = PeriodMap::new(
            self,
            balance.core.extent(&at.coefficients).max(0.1 * size),
            at.parameter,
        );
        let (last, inner) = (map.scaled(last, at.parameter), map.scaled(inner, beside.parameter));
        let direction = last - inner;
        let length = direction.norm();
        if length.is_nan() || length <= 0.0 {
            return;
        }
        let Some(first) = map.corrected(&last, &(direction / length)) else {
            return;
        };
        let others: Vec<BranchPath> = (0..paths.len())
            .filter(|other| *other != index)
            .map(|other| paths[other].clone())
            .collect();
        let met = |node: &BranchNode| self.is_met(balance, &others, node);
        let (shots, end) = map.walk(first, &met, balance);
        let mut outward = shots.iter().skip(1).map(|shot| map.node(balance, shot));
        let path = &mut paths[index];
        path.ends[side] = end;
        match side {
            0 => {
                // Points are in the order of the branch, and so are their tangents.
                let mut all: Vec<BranchNode> = outward
                    .by_ref()
                    .map(|node| BranchNode {
                        tangent: -node.tangent,
                        orientation: -node.orientation,
                        ..node
                    })
                    .collect();
                all.reverse();
                all.extend(path.nodes.drain(..).skip(skipped));
                path.nodes = all;
            }
            _ => {
                path.nodes.truncate(path.nodes.len() - skipped);
                path.nodes.extend(outward);
            }
        }
    }

    /// The branch on which a motion across jumps lies, shifted by drive periods or mirrored; `None` if there
    /// is none.
    pub(super) fn known_across_jumps(
        &self,
        balance: &DrivenBalance,
        paths: &[BranchPath],
        node: &BranchNode,
        start: [f64; 2],
    ) -> Option<KnownMotion> {
        let size = balance.core.extent(&node.coefficients);
        let images = match self.driven.self_excited {
            true => vec![start],
            false => self.images(MotionGuess { start, parameter: node.parameter, size }),
        };
        let on = |start: [f64; 2]| {
            paths.iter().position(|path| self.lies_on(balance, path, start, node.parameter, size))
        };
        images.into_iter().enumerate().find_map(|(halves, start)| match halves % 2 {
            0 => on(start).map(|_| KnownMotion::Itself),
            _ => on(start).map(KnownMotion::Mirrored),
        })
    }

    /// Whether a motion that does not stick lies on one of these branches.
    fn is_met(&self, balance: &DrivenBalance, paths: &[BranchPath], node: &BranchNode) -> bool {
        let Some(truth) = node.truth else {
            return false;
        };
        let size = balance.core.extent(&node.coefficients);
        paths.iter().any(|path| self.lies_on(balance, path, truth.start, node.parameter, size))
    }

    /// Whether a motion with this start lies on a branch.
    fn lies_on(
        &self,
        balance: &DrivenBalance,
        path: &BranchPath,
        start: [f64; 2],
        parameter: f64,
        size: f64,
    ) -> bool {
        /// Largest error of an interpolation between two points, and largest difference of equal
        /// motions, relative to their size.
        const NEAR: f64 = 0.25;
        const SAME: f64 = 1e-4;
        let omega = self.driven.frequency_at(parameter);
        let apart = |other: [f64; 2]| (other[0] - start[0]).hypot((other[1] - start[1]) / omega);
        path.nodes.windows(2).any(|pair| {
            let [one, other] = pair else { return false };
            let Some(part) = one.part_of_way(other, parameter) else {
                return false;
            };
            let starts = [one, other].map(|node| node.begins(balance));
            let guess =
                [0, 1].map(|index| starts[0][index] + part * (starts[1][index] - starts[0][index]));
            let map = PeriodMap::new(self, size, parameter);
            let truth = || map.shoot(guess, parameter).map(|shot| map.start(&shot.at).0);
            apart(guess) <= NEAR * size && truth().is_some_and(|truth| apart(truth) <= SAME * size)
        })
    }

    /// A motion between two of a branch, at this fraction of the way, if one of them was found by
    /// shooting.
    pub(super) fn stuck_between(
        &self,
        balance: &DrivenBalance,
        from: &BranchNode,
        to: &BranchNode,
        part: f64,
    ) -> Option<BranchNode> {
        let size =
            balance.core.extent(&from.coefficients).max(balance.core.extent(&to.coefficients));
        let map = PeriodMap::new(self, size, from.parameter);
        let [start, end] = [from, to].map(|node| map.scaled(node.begins(balance), node.parameter));
        let way = end - start;
        let length = way.norm();
        if length == 0.0 {
            return Some(from.clone());
        }
        let shot = map.corrected(&(start + way * part), &(way / length))?;
        Some(map.node(balance, &shot))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::ResponseRequest;

    /// A motion across a step of the force loses its symmetry: from the motion alone the lopsided ones are
    /// found behind the crossing, by the null vector of the map, once with their mirror images. Integrated by
    /// the classical Runge-Kutta method in small steps they return after a period and not, mirrored, after
    /// half of one.
    #[test]
    fn the_branch_that_crosses_one_across_jumps_is_followed() {
        let equation = "x'' + x'/10 + x^3 + sgn(x)/5 = F*cos(t)";
        let question = ResponseRequest::new(equation, "F", [2.3, 2.7], "").expect("a request");
        let asked = PreparedRequest::new(&question, question.equations.oscillator().expect("one"))
            .expect("a request");
        let balance = DrivenBalance::new(&asked.driven, 16);
        let positions = (0..SAMPLES)
            .map(|index| 1.8 * (std::f64::consts::TAU * index as f64 / SAMPLES as f64).cos());
        let seed = Seed {
            parameter: 2.3,
            frequency: 1.0,
            positions: positions.collect(),
            start: Some([1.83, 0.05]),
        };
        let mut paths = vec![];
        let seeds = [seed];
        asked.follow_sticking(&balance, &seeds, &mut paths, 1.8);
        assert_eq!(paths.len(), 1);
        asked.judged_paths(&balance, &seeds, &mut paths);
        let [_, lopsided] = &paths[..] else { panic!("{}", paths.len()) };
        assert!(lopsided.mirrored && lopsided.ends == [BranchEnd::Crossing, BranchEnd::Range]);
        assert!((lopsided.nodes[0].parameter - 2.47535).abs() < 1e-4);
        let node = &lopsided.nodes[lopsided.nodes.len() / 2];
        let start = node.truth.expect("a motion").start;
        let after = |steps: usize| {
            let h = std::f64::consts::TAU / 40_000.0;
            let rate = |t: f64, [x, v]: [f64; 2]| {
                [v, node.parameter * t.cos() - v / 10.0 - x.powi(3) - x.signum() / 5.0]
            };
            let along = |y: [f64; 2], k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
            (0..steps).fold(start, |y, step| {
                let t = h * step as f64;
                let one = rate(t, y);
                let two = rate(t + 0.5 * h, along(y, one, 0.5 * h));
                let three = rate(t + 0.5 * h, along(y, two, 0.5 * h));
                let four = rate(t + h, along(y, three, h));
                let mean = [0, 1].map(|i| (one[i] + 2.0 * (two[i] + three[i]) + four[i]) / 6.0);
                along(y, mean, h)
            })
        };
        let apart = |y: [f64; 2], sign: f64| (y[0] - sign * start[0]).hypot(y[1] - sign * start[1]);
        assert!(apart(after(40_000), 1.0) < 1e-3);
        assert!(apart(after(20_000), -1.0) > 0.05);
    }
}

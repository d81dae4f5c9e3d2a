//! Branches of motions that meet corners of the force, such as contacts, by shooting.
//!
//! ```text
//! P(y; p) = y,   P: position and velocity a period later, by Taylor series across the corners
//! ```
//!
//! A motion that meets a stiff stop turns within a small part of its period: harmonic balance takes
//! as many harmonics as the stop is stiff, and its branch waves about the true one. The map of a
//! period does not: the cost of a point depends on the number of touches alone
//! ([`series`](super::series)), its derivatives are the variations of the same motion, and its
//! harmonics are read off the motion. The branch is that of
//! [`orbit_branch`](crate::numeric::orbit_branch). In: initial motions. Out: branches whose points
//! hold their orbits. The judge follows each of them anew, by a Runge-Kutta method in time that
//! evaluates the force as it was given.
//!
//! A point costs two to four periods of 6 to 40 steps, each of eight series, and the samples of
//! its harmonics; it keeps 129 coefficients.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, Matrix2};

use super::balance::DrivenBalance;
use super::branches::{KnownMotion, largest, smallest};
use super::continuation::{BranchEnd, BranchNode, BranchPath};
use super::jump::positions_on;
use super::seeds::Seed;
use super::series::PeriodSeries;
use super::stability::{Floquet, ORBIT_SAMPLES, TrueMotion, half_of_travel};
use super::{LONGEST_STEP, MOST_BRANCHES, MOST_POINTS, PreparedRequest};
use crate::numeric::orbit_branch::{
    OrbitBranchEnd, OrbitBranchLimits, OrbitEquations, OrbitPoint, PeriodImage,
};
use crate::system::Path;

/// The data of an orbit that a branch keeps.
#[derive(Clone, Debug)]
struct KeptOrbit {
    coefficients: DVector<f64>,
    truth: TrueMotion,
}

type Orbit = OrbitPoint<KeptOrbit>;

/// Number of states: position and velocity.
const STATES: usize = 2;

/// A point of a branch with its orbit.
fn node_of(orbit: Orbit) -> BranchNode {
    BranchNode {
        parameter: orbit.parameter(),
        coefficients: orbit.kept.coefficients,
        tangent: orbit.tangent,
        orientation: orbit.orientation,
        truth: Some(orbit.kept.truth),
    }
}

/// The orbit of a point of a branch; `None` if it has none.
fn orbit_of(node: &BranchNode) -> Option<Orbit> {
    let truth = node.truth?;
    let [x, v] = truth.start;
    Some(OrbitPoint {
        unknowns: DVector::from_vec(vec![x, v, node.parameter]),
        monodromy: DMatrix::from_column_slice(STATES, STATES, truth.floquet.monodromy.as_slice()),
        tangent: node.tangent.clone(),
        orientation: node.orientation,
        kept: KeptOrbit { coefficients: node.coefficients.clone(), truth },
    })
}

fn end_of(end: OrbitBranchEnd) -> BranchEnd {
    match end {
        OrbitBranchEnd::Range => BranchEnd::Range,
        OrbitBranchEnd::Closed => BranchEnd::Closed,
        OrbitBranchEnd::Joined => BranchEnd::Crossing,
        OrbitBranchEnd::Lost => BranchEnd::Lost,
        OrbitBranchEnd::Points => BranchEnd::Points,
        OrbitBranchEnd::Refused => BranchEnd::Unbounded,
        OrbitBranchEnd::Interrupted => BranchEnd::Interrupted,
    }
}

impl PreparedRequest<'_> {
    /// Calls a function with the equations of orbits; `size` is that of the largest motion. Returns
    /// `None` if the equation is not treated by shooting.
    fn with_orbits<T>(
        &self,
        balance: &DrivenBalance,
        size: f64,
        call: impl FnOnce(&OrbitEquations<Path, KeptOrbit>) -> T,
    ) -> Option<T> {
        let series = self.period_series.as_ref()?;
        let map = |start: &DVector<f64>, parameter: f64| {
            let runs = self.driven.frequency_at(parameter) > 0.0;
            runs.then(|| series.period(start, parameter)).flatten()
        };
        let keep = |unknowns: &DVector<f64>, image: &PeriodImage<Path>| {
            self.kept(balance, series, unknowns, image)
        };
        let sizes = |orbit: &Orbit| {
            let own = balance.core.extent(&orbit.kept.coefficients);
            self.orbit_sizes(own, size, orbit.parameter())
        };
        Some(call(&OrbitEquations {
            map: &map,
            smooth: false,
            accuracy: 4e-15,
            // Past the touch of a stop that is very stiff the way leads by orbits that miss by as much.
            rounding: 1e-6,
            keep: &keep,
            sizes: &sizes,
        }))
    }

    /// The sizes of position, velocity and parameter beside a motion of this extent.
    fn orbit_sizes(&self, own: f64, size: f64, parameter: f64) -> DVector<f64> {
        /// The smallest size used as a scale, as a fraction of the largest.
        const SMALLEST: f64 = 0.1;
        let own = own.max(SMALLEST * size).max(1e-12);
        let [low, high] = self.question.range;
        DVector::from_vec(vec![own, own * self.driven.frequency_at(parameter), high - low])
    }

    fn kept(
        &self,
        balance: &DrivenBalance,
        series: &PeriodSeries,
        unknowns: &DVector<f64>,
        image: &PeriodImage<Path>,
    ) -> KeptOrbit {
        let positions = positions_on(&image.path, ORBIT_SAMPLES);
        let frequency = self.driven.frequency_at(unknowns[STATES]);
        let monodromy = Matrix2::from_column_slice(image.by_start.as_slice());
        let floquet = Floquet { monodromy, self_excited: false };
        let start = [unknowns[0], unknowns[1]];
        let truth = TrueMotion::new(start, frequency, floquet, &positions, 0.0);
        let peak = half_of_travel(&image.path).unwrap_or(truth.peak);
        KeptOrbit {
            coefficients: balance.core.transformed(&series.transform, &[&positions]),
            truth: TrueMotion { peak, ..truth },
        }
    }

    /// The orbit near a start, of a motion of about this extent.
    fn orbit_near(
        &self,
        equations: &OrbitEquations<Path, KeptOrbit>,
        start: [f64; 2],
        parameter: f64,
        [own, size]: [f64; 2],
    ) -> Option<Orbit> {
        let sizes = self.orbit_sizes(own, size, parameter);
        let guess = DVector::from_column_slice(&start);
        equations.orbit_at(&guess, parameter, &sizes)
    }

    /// The motion that shooting finds from rest at an equilibrium, and its extent; `None` if it
    /// finds none.
    pub(super) fn shot_from_rest(
        &self,
        balance: &DrivenBalance,
        place: f64,
        parameter: f64,
    ) -> Option<(Seed, f64)> {
        // The first search does not know the size of the motion.
        let (first, extent) = self.shot_near(balance, [place, 0.0], parameter, 1.0)?;
        self.shot_near(balance, first.start?, parameter, extent)
    }

    /// The motion that shooting finds from a start, of about this extent, and its own extent; `None`
    /// if it finds none.
    pub(super) fn shot_near(
        &self,
        balance: &DrivenBalance,
        start: [f64; 2],
        parameter: f64,
        extent: f64,
    ) -> Option<(Seed, f64)> {
        self.with_orbits(balance, 0.0, |equations| {
            let orbit = self.orbit_near(equations, start, parameter, [extent, 0.0])?;
            let extent = balance.core.extent(&orbit.kept.coefficients);
            Some((self.seed_of(balance, &node_of(orbit)), extent))
        })?
    }

    /// An initial motion from a point of a branch.
    fn seed_of(&self, balance: &DrivenBalance, node: &BranchNode) -> Seed {
        let start = node.truth.map(|truth| truth.start);
        Seed { start, ..self.seed(balance, &node.coefficients, node.parameter) }
    }

    /// The branches that are known and those through these motions, each once.
    pub(super) fn shot_branches(
        &self,
        balance: &DrivenBalance,
        seeds: &[Seed],
        size: f64,
        known: &[BranchPath],
    ) -> Vec<BranchPath> {
        /// Ratio to the size below which two starts are those of one motion.
        const SAME: f64 = 1e-3;
        let mut paths = known.to_vec();
        let mut tried: Vec<(f64, [f64; 2])> = Vec::new();
        for seed in seeds {
            let Some(start) = seed.start else { continue };
            if paths.len() >= MOST_BRANCHES || self.question.interrupt.is_requested() {
                break;
            }
            let omega = self.driven.frequency_at(seed.parameter);
            let is_near = |(parameter, other): &(f64, [f64; 2])| {
                let apart = (start[0] - other[0]).hypot((start[1] - other[1]) / omega);
                *parameter == seed.parameter && apart <= SAME * seed.extent()
            };
            if tried.iter().any(is_near) {
                continue;
            }
            tried.push((seed.parameter, start));
            let largest = paths.iter().map(|path| largest(balance, path)).fold(size, f64::max);
            let branch = |equations: &OrbitEquations<Path, KeptOrbit>, paths: &mut Vec<_>| {
                let sizes = [seed.extent(), largest];
                let orbit = self.orbit_near(equations, start, seed.parameter, sizes)?;
                match self.was_known(balance, paths, &node_of(orbit.clone())) {
                    true => None,
                    false => Some(self.orbit_branch(equations, balance, orbit, largest)),
                }
            };
            let found =
                self.with_orbits(balance, largest, |equations| branch(equations, &mut paths));
            if let Some(path) = found.flatten() {
                self.keep(balance, path, &mut paths);
            }
        }
        self.remove_lost_parts(balance, &mut paths, known.len());
        for index in known.len()..paths.len() {
            self.mark_mirrored_orbit(balance, &mut paths, index);
        }
        paths
    }

    /// The branch through an orbit, in the range of the request.
    fn orbit_branch(
        &self,
        equations: &OrbitEquations<Path, KeptOrbit>,
        balance: &DrivenBalance,
        orbit: Orbit,
        ordinary: f64,
    ) -> BranchPath {
        const ENORMOUS: f64 = 1e4;
        let extent = |orbit: &Orbit| balance.core.extent(&orbit.kept.coefficients);
        let bound = ENORMOUS * extent(&orbit).max(ordinary);
        let limits = OrbitBranchLimits {
            range: self.question.range,
            longest: LONGEST_STEP,
            most: MOST_POINTS,
            interrupt: self.question.interrupt,
        };
        let (orbits, ends) =
            equations.branch_through(orbit, &limits, &|orbit| extent(orbit) > bound);
        let nodes = orbits.into_iter().map(node_of).collect();
        BranchPath { nodes, ends: ends.map(end_of), mirrored: false }
    }

    /// The motions at which a branch that leaves the range re-enters it, if it is followed up to
    /// the bounds `wide`.
    pub(super) fn shot_reentries(
        &self,
        balance: &DrivenBalance,
        path: &BranchPath,
        wide: [f64; 2],
    ) -> Vec<(Seed, f64)> {
        /// Largest number of points beyond the range.
        const MOST: usize = 200;
        let ends = [path.nodes.first(), path.nodes.last()].into_iter().zip(path.ends).enumerate();
        let ends = ends.filter(|(_, (_, end))| *end == BranchEnd::Range);
        let outward = ends.filter_map(|(side, (node, _))| {
            let orbit = orbit_of(node?)?;
            Some(if side == 0 { orbit.reversed() } else { orbit })
        });
        let [low, high] = self.question.range;
        // Only where a branch comes back matters, not its course.
        let limits = OrbitBranchLimits {
            range: wide,
            longest: 3.0 * LONGEST_STEP,
            most: MOST,
            interrupt: self.question.interrupt,
        };
        let size = largest(balance, path);
        let all = |equations: &OrbitEquations<Path, KeptOrbit>| {
            let back = |pair: &[Orbit]| {
                let [from, to] = pair else { return None };
                let inside = to.parameter().clamp(low, high);
                // An orbit on the bound itself has not left the range yet.
                let left = from.parameter().clamp(low, high) != from.parameter();
                let part = (inside - from.parameter()) / (to.parameter() - from.parameter());
                if !left || !(0.0..=1.0).contains(&part) {
                    return None;
                }
                let guess = &from.unknowns + (&to.unknowns - &from.unknowns) * part;
                let own = balance.core.extent(&to.kept.coefficients);
                self.orbit_near(equations, [guess[0], guess[1]], inside, [own, size])
            };
            let mut found = Vec::new();
            for start in outward {
                let (orbits, _) = equations.follow(start, &limits, &|_| false);
                found.extend(orbits.windows(2).filter_map(back).map(|orbit| {
                    let extent = balance.core.extent(&orbit.kept.coefficients);
                    (self.seed_of(balance, &node_of(orbit)), extent)
                }));
            }
            found
        };
        self.with_orbits(balance, size, all).unwrap_or_default()
    }

    /// The point between two of a branch, at this fraction of the way.
    pub(super) fn shot_between(
        &self,
        balance: &DrivenBalance,
        from: &BranchNode,
        to: &BranchNode,
        part: f64,
    ) -> Option<BranchNode> {
        let orbits = [orbit_of(from)?, orbit_of(to)?];
        self.with_orbits(balance, 0.0, |equations| {
            equations.between(&orbits[0], &orbits[1], part).map(node_of)
        })?
    }

    /// Motions beside a crossing of branches, with the branches through them.
    pub(super) fn shot_beside_crossing(
        &self,
        balance: &DrivenBalance,
        at: &BranchNode,
        size: f64,
        mut is_known: impl FnMut(&BranchNode) -> bool,
    ) -> Vec<BranchPath> {
        let Some(orbit) = orbit_of(at) else { return vec![] };
        let branches = |equations: &OrbitEquations<Path, KeptOrbit>| {
            let mut found = Vec::new();
            for beside in equations.beside_crossing(&orbit) {
                if !is_known(&node_of(beside.clone())) {
                    found.push(self.orbit_branch(equations, balance, beside, size));
                }
            }
            found
        };
        self.with_orbits(balance, size, branches).unwrap_or_default()
    }

    /// The starts of a motion shifted by periods of the drive, and those of its mirror images,
    /// which are half a period later.
    fn starts_of_images(&self, start: [f64; 2], parameter: f64) -> Option<[Vec<[f64; 2]>; 2]> {
        let begin = DVector::from_column_slice(&start);
        let path = self.period_series.as_ref()?.period(&begin, parameter)?.path;
        let periods = self.question.periods;
        let after = |halves: usize| {
            let phase = TAU * halves as f64 / (2 * periods) as f64;
            Some([path.state_at(phase, 0)?, path.state_at(phase, 1)?])
        };
        let shifted = (0..periods).filter_map(|count| after(2 * count)).collect();
        let mirrored = (0..periods).filter_map(|count| after(2 * count + 1));
        Some([shifted, mirrored.map(|state| state.map(|value| -value)).collect()])
    }

    /// The branch on which an orbit lies, shifted by drive periods or mirrored; `None` if there is
    /// none.
    pub(super) fn known_orbit(
        &self,
        balance: &DrivenBalance,
        paths: &[BranchPath],
        node: &BranchNode,
    ) -> Option<KnownMotion> {
        /// Largest error of an interpolation between two points, and largest difference of equal
        /// motions, relative to their size.
        const NEAR: f64 = 0.2;
        const SAME: f64 = 1e-5;
        let (truth, parameter) = (node.truth?, node.parameter);
        let size = balance.core.extent(&node.coefficients).max(smallest(balance, paths));
        let [shifted, mirrored] = self.starts_of_images(truth.start, parameter)?;
        let is_one = |[x, v]: [f64; 2], starts: &[[f64; 2]], within: f64| {
            starts.iter().any(|start| {
                let same_speed = (v - start[1]).abs() <= within * size * truth.frequency;
                let same_place = (x - start[0]).abs() <= within * size;
                same_speed && (same_place || self.repeats_after(x - start[0], parameter))
            })
        };
        let between = |pair: &[BranchNode], starts: &[[f64; 2]]| {
            let [one, other] = pair else { return false };
            let Some(part) = one.part_of_way(other, parameter) else {
                return false;
            };
            let [from, to] = [one, other].map(|node| node.begins(balance));
            let guess = [0, 1].map(|index| from[index] + part * (to[index] - from[index]));
            let solved = |equations: &OrbitEquations<Path, KeptOrbit>| {
                self.orbit_near(equations, guess, parameter, [size, 0.0])
            };
            is_one(guess, starts, NEAR)
                && self
                    .with_orbits(balance, size, solved)
                    .flatten()
                    .is_some_and(|orbit| is_one(orbit.kept.truth.start, starts, SAME))
        };
        let on = |starts: &[[f64; 2]]| {
            let holds = |path: &BranchPath| path.nodes.windows(2).any(|pair| between(pair, starts));
            paths.iter().position(holds)
        };
        match on(&shifted) {
            Some(_) => Some(KnownMotion::Itself),
            None => on(&mirrored).map(KnownMotion::Mirrored),
        }
    }

    /// Marks a branch whose mirror image was not found: one for which the image of one of its
    /// motions is a motion of the same equation and on no branch itself.
    fn mark_mirrored_orbit(&self, balance: &DrivenBalance, paths: &mut [BranchPath], index: usize) {
        const SAME: f64 = 1e-6;
        let nodes = &paths[index].nodes;
        let middle = &nodes[nodes.len() / 2];
        let parameter = middle.parameter;
        let own = balance.core.extent(&middle.coefficients);
        let image = |equations: &OrbitEquations<Path, KeptOrbit>| {
            let [_, mirrored] = self.starts_of_images(middle.truth?.start, parameter)?;
            let start = *mirrored.first()?;
            let found = self.orbit_near(equations, start, parameter, [own, 0.0])?;
            let [x, v] = found.kept.truth.start;
            let omega = self.driven.frequency_at(parameter);
            let moved = (x - start[0]).hypot((v - start[1]) / omega);
            (moved <= SAME * own).then(|| node_of(found))
        };
        if let Some(image) = self.with_orbits(balance, own, image).flatten() {
            self.was_known(balance, paths, &image);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::bifurcation::BifurcationKind;
    use crate::response::{ResponseDiagram, ResponseRequest, SteadyMotion};

    const DUFFING: &str = "x'' + x'/10 + x + x^3 - F*cos(Omega*t) = 0";
    const CONTACT: &str = "x'' + x'/10 + x + g*max(x - 0.5, 0)^1.5 - F*cos(Omega*t) = 0";

    fn request(equation: &str, range: [f64; 2], values: &str) -> ResponseRequest {
        ResponseRequest::new(equation, "Omega", range, values).expect("a request")
    }

    /// The response by shooting, whether the force has corners or not.
    fn shot(question: &ResponseRequest) -> ResponseDiagram {
        let mut asked =
            PreparedRequest::new(question, question.equations.oscillator().expect("one"))
                .expect("a request");
        asked.period_series = PeriodSeries::new(&asked.driven);
        asked.shot_response().expect("a response")
    }

    fn folds(response: &ResponseDiagram) -> Vec<[f64; 2]> {
        let folds = response.bifurcations.iter();
        let folds = folds.filter(|found| found.kind == BifurcationKind::Fold);
        folds.map(|fold| [fold.parameter, fold.amplitude]).collect()
    }

    /// det M(T) = exp(-c T), whatever the motion meets.
    fn has_constant_damping(points: &[SteadyMotion], damping: f64, within: f64) {
        for point in points {
            let [one, other] = point.multipliers.expect("multipliers");
            let product = (one * other).re;
            let exact = (-damping * TAU / point.frequency).exp();
            assert!((product / exact - 1.0).abs() < within, "{point:?}: {product} {exact}");
        }
    }

    /// The branch by shooting is that of harmonic balance, which shares nothing with it but the
    /// steps along a branch.
    #[test]
    fn a_smooth_branch_is_that_of_harmonic_balance() {
        let question = request(DUFFING, [0.8, 2.0], "F = 3/10");
        let shot = shot(&question);
        let balanced = ResponseRequest { harmonics: Some(24), ..question.clone() };
        let balanced = crate::response::respond(&balanced).expect("a response");
        assert!(shot.branches.len() == 1 && balanced.branches.len() == 1);
        for (one, other) in folds(&shot).iter().zip(folds(&balanced)) {
            assert!((one[0] - other[0]).abs() < 1e-9, "{one:?} {other:?}");
            assert!((one[1] - other[1]).abs() < 1e-6, "{one:?} {other:?}");
        }
        assert_eq!(folds(&shot).len(), 2);
        has_constant_damping(&shot.branches[0].points, 0.1, 1e-10);
        // The orbit at the parameter of each point of the other branch.
        let asked = PreparedRequest::new(&question, question.equations.oscillator().expect("one"))
            .expect("a request");
        let asked = PreparedRequest { period_series: PeriodSeries::new(&asked.driven), ..asked };
        let balance = DrivenBalance::new(&asked.driven, 24);
        for point in &balanced.branches[0].points {
            let near = |equations: &OrbitEquations<Path, KeptOrbit>| {
                asked.orbit_near(equations, point.start, point.parameter, [point.peak, 0.0])
            };
            let orbit = asked.with_orbits(&balance, 1.0, near).flatten().expect("an orbit");
            let KeptOrbit { coefficients, truth } = orbit.kept;
            let amplitude = coefficients[1].hypot(coefficients[2]);
            assert!((amplitude / point.amplitude - 1.0).abs() < 1e-9, "{point:?} {amplitude}");
            let [one, _] = truth.floquet.multipliers();
            let [other, _] = point.multipliers.expect("multipliers");
            assert!((one.norm() - other.norm()).abs() < 1e-7, "{one} {other}");
        }
    }

    /// The derivatives of the map are those of differences, by the start and by the parameter,
    /// through contact.
    #[test]
    fn the_map_through_contact_has_the_derivatives_of_differences() {
        let question = request(CONTACT, [0.5, 2.5], "F = 3/10, g = 1000");
        let asked = PreparedRequest::new(&question, question.equations.oscillator().expect("one"))
            .expect("a request");
        let series = asked.period_series.as_ref().expect("series");
        let (start, omega) = (DVector::from_vec(vec![0.3, 0.7]), 1.3);
        let image = series.period(&start, omega).expect("a period");
        assert!(image.path.states_at(TAU).is_some());
        let end = |by: [f64; 3]| {
            let start = DVector::from_vec(vec![start[0] + by[0], start[1] + by[1]]);
            series.period(&start, omega + by[2]).expect("a period").end
        };
        for index in 0..3 {
            const STEP: f64 = 1e-6;
            let step = |sign: f64| {
                let mut by = [0.0; 3];
                by[index] = sign * STEP;
                by
            };
            let difference = (end(step(1.0)) - end(step(-1.0))) / (2.0 * STEP);
            let slope = match index {
                2 => image.by_parameter.clone(),
                _ => image.by_start.column(index).into_owned(),
            };
            assert!((&slope - &difference).norm() < 1e-5 * slope.norm(), "{slope} {difference}");
        }
    }

    /// One branch of motions with stiff contact, judged by Runge-Kutta; the number of steps does not
    /// depend on the stiffness.
    #[test]
    fn a_stiff_contact_costs_no_more_steps_than_a_soft_one() {
        let mut steps = Vec::new();
        for stiffness in ["1e3", "1e6", "1e9"] {
            let values = format!("F = 3/10, g = {stiffness}");
            let question = request(CONTACT, [1.4, 1.5], &values);
            let found = shot(&question);
            let points = || found.branches.iter().flat_map(|branch| &branch.points);
            assert!(found.error.is_some_and(|error| error < 1e-4), "{:?}", found.error);
            for branch in &found.branches {
                has_constant_damping(&branch.points, 0.1, 1e-7);
            }
            let asked =
                PreparedRequest::new(&question, question.equations.oscillator().expect("one"))
                    .expect("a request");
            let series = asked.period_series.as_ref().expect("series");
            let count = |point: &SteadyMotion| {
                let start = DVector::from_column_slice(&point.start);
                series.period(&start, point.parameter).expect("a period").path.step_count()
            };
            // The motions in contact.
            let touching = points().filter(|point| point.peak > 0.8);
            steps.push(touching.map(count).max().expect("a motion in contact"));
        }
        let [least, most] = [steps.iter().min(), steps.iter().max()].map(Option::unwrap);
        assert!(*most < 40 && *most <= least + 4, "{steps:?}");
    }

    /// A corner whose place is the parameter has its own recurrences for every value.
    #[test]
    fn the_place_of_a_stop_may_vary() {
        let equation = "x'' + x'/5 + x + 50*max(x - d, 0)^1.5 = 0.4*cos(1.2*t)";
        let question = ResponseRequest::new(equation, "d", [0.2, 1.5], "").expect("a request");
        let found = shot(&question);
        assert!(found.error.is_some_and(|error| error < 1e-5), "{:?}", found.error);
        // Beyond its reach the linear motion, whose mean is zero, is one of them.
        let linear = 0.4 / ((1.0_f64 - 1.44).powi(2) + 0.24_f64.powi(2)).sqrt();
        let points = found.branches.iter().flat_map(|branch| &branch.points);
        let free = points.filter(|point| point.harmonics[0][0].abs() < 1e-9);
        let free: Vec<&SteadyMotion> = free.collect();
        assert!(free.len() > 3);
        for point in free {
            assert!((point.peak / linear - 1.0).abs() < 1e-9, "{point:?}");
            assert!(point.parameter > linear - 1e-9, "{point:?}");
        }
    }
}

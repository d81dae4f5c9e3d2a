//! The list of branches without repetitions: no branch shifted in time, no mirror image, no second
//! half of one that returns.

use nalgebra::DVector;

use super::balance::DrivenBalance;
use super::continuation::{self, BranchEnd, BranchNode, BranchPath, ContinuationSettings};
use super::seeds::{Seed, size_of};
use super::{MOST_BRANCHES, PreparedRequest};

/// The relation of a known motion to a branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum KnownMotion {
    /// The motion lies on a branch.
    Itself,
    /// Its mirror image lies on this one.
    Mirrored(usize),
}

impl PreparedRequest<'_> {
    /// The branches that are known and those through these motions, each once.
    pub(super) fn branches(
        &self,
        balance: &DrivenBalance,
        seeds: &[Seed],
        size: f64,
        known: &[BranchPath],
    ) -> Vec<BranchPath> {
        let mut paths = known.to_vec();
        let ordinary = size_of(seeds);
        for seed in seeds {
            if paths.len() >= MOST_BRANCHES || self.question.interrupt.is_requested() {
                break;
            }
            let guess = balance.core.unknowns_of(&[&seed.positions], seed.frequency);
            let Some(found) = balance.solve(&guess, seed.parameter) else {
                continue;
            };
            let walk = self.walk(
                ordinary,
                paths
                    .iter()
                    .map(|path| largest(balance, path))
                    .fold(size.max(balance.core.extent(&found)), f64::max),
            );
            if walk.is_cut_off(balance, &found) {
                continue;
            }
            let known = self.known_coefficients(balance, &paths, &found, seed.parameter);
            if self.mark(&mut paths, known) {
                continue;
            }
            if let Some(path) = walk.branch_through(balance, &found, seed.parameter) {
                self.keep(balance, path, &mut paths);
            }
        }
        for index in known.len()..paths.len() {
            self.mark_mirrored(balance, &mut paths, index);
        }
        paths
    }

    /// Marks a branch whose mirror image was not found: one for which the image of one of its
    /// motions is a motion of the same equation and on no branch itself.
    fn mark_mirrored(&self, balance: &DrivenBalance, paths: &mut [BranchPath], index: usize) {
        const SAME: f64 = 1e-6;
        let nodes = &paths[index].nodes;
        let middle = &nodes[nodes.len() / 2];
        let period = std::f64::consts::TAU / self.question.periods as f64;
        let (parameter, image) =
            (middle.parameter, -balance.core.later(&middle.coefficients, 0.5 * period));
        let is_motion = balance
            .solve(&image, parameter)
            .is_some_and(|found| (&found - &image).norm() <= SAME * image.norm());
        if is_motion {
            let known = self.known_coefficients(balance, paths, &image, parameter);
            self.mark(paths, known);
        }
    }

    /// Marks the branch of which a motion is a mirror image; returns whether the motion is known.
    fn mark(&self, paths: &mut [BranchPath], known: Option<KnownMotion>) -> bool {
        if let Some(KnownMotion::Mirrored(index)) = known {
            paths[index].mirrored = true;
        }
        known.is_some()
    }

    /// Whether the motion of a point is known; where it is a mirror image, its branch is marked.
    pub(super) fn was_known(
        &self,
        balance: &DrivenBalance,
        paths: &mut [BranchPath],
        node: &BranchNode,
    ) -> bool {
        let known = self.known_motion(balance, paths, node);
        self.mark(paths, known)
    }

    /// Adds a branch unless it, or its mirror image, is known already.
    pub(super) fn keep(
        &self,
        balance: &DrivenBalance,
        mut path: BranchPath,
        paths: &mut Vec<BranchPath>,
    ) {
        if path.nodes.len() < 2 || self.is_centre(&path) {
            return;
        }
        self.cut_at_crossing(balance, &mut path);
        let [first, middle, last] =
            [0, path.nodes.len() / 2, path.nodes.len() - 1].map(|index| &path.nodes[index]);
        let ends = match path.ends[0] {
            BranchEnd::Closed => vec![middle],
            _ if path.ends[1] == BranchEnd::Crossing => vec![first],
            _ => vec![first, last],
        };
        let known = |node: &BranchNode| self.known_motion(balance, paths, node);
        match ends.into_iter().find_map(known).filter(|_| known(middle).is_some()) {
            Some(KnownMotion::Itself) => {}
            Some(KnownMotion::Mirrored(index)) => paths[index].mirrored = true,
            None => paths.push(path),
        }
    }

    /// Removes the branches from this index on that were lost on the way and lie on another one, which
    /// was followed from beyond that place.
    pub(super) fn remove_lost_parts(
        &self,
        balance: &DrivenBalance,
        paths: &mut Vec<BranchPath>,
        begin: usize,
    ) {
        let is_part = |part: &BranchPath| {
            let count = part.nodes.len();
            let is_on = |whole: &BranchPath| {
                whole.nodes.len() > count
                    && (0..4).all(|quarter| {
                        let node = &part.nodes[quarter * count / 4];
                        let known = self.known_motion(balance, std::slice::from_ref(whole), node);
                        known == Some(KnownMotion::Itself)
                    })
            };
            part.ends.contains(&BranchEnd::Lost) && paths.iter().any(is_on)
        };
        let stays: Vec<bool> = { paths.iter().enumerate() }
            .map(|(index, path)| index < begin || !is_part(path))
            .collect();
        let mut stays = stays.into_iter();
        paths.retain(|_| stays.next().unwrap_or(true));
    }

    /// A branch that begins at a crossing with another one returns from there as its own image:
    /// that half is removed. Other branches may cross before that one, and shooting may come to the
    /// other branch by a sharp crossing, where two stops are touched at once.
    fn cut_at_crossing(&self, balance: &DrivenBalance, path: &mut BranchPath) {
        /// Largest number of crossings that are looked at.
        const MOST: usize = 8;
        let turns_of = |nodes: &[BranchNode]| -> Vec<usize> {
            let turns = |pair: &[BranchNode]| pair[0].orientation * pair[1].orientation < 0.0;
            let turns = nodes.windows(2).enumerate().filter(|(_, pair)| turns(pair));
            turns.map(|(index, _)| index).collect()
        };
        let mut turns = turns_of(&path.nodes);
        // A closed branch may go through two crossings and back as its image: it is begun at the last
        // one, so that the way to the first is not divided. The first point beyond comes again at
        // the end.
        let is_whole = path.nodes.first().zip(path.nodes.last()).is_some_and(|(first, last)| {
            path.ends[0] == BranchEnd::Closed && first.coefficients == last.coefficients
        });
        if let ([_, .., last], true) = (turns.as_slice(), is_whole) {
            path.nodes.pop();
            path.nodes.rotate_left(*last);
            let again: Vec<BranchNode> = path.nodes[..2].to_vec();
            path.nodes.extend(again);
            turns = turns_of(&path.nodes);
        }
        let is_begun_at_crossing = path.ends[0] == BranchEnd::Closed && turns.first() == Some(&0);
        let begins = usize::from(is_begun_at_crossing);
        for (count, &index) in turns.iter().enumerate().skip(begins).take(MOST) {
            let next = turns.get(count + 1).map_or(path.nodes.len(), |next| next + 1);
            let (before, behind) = (&path.nodes[..=index], &path.nodes[index + 1..next]);
            let half = BranchPath { nodes: before.to_vec(), ends: path.ends, mirrored: false };
            let image =
                |node: &BranchNode| self.known_motion(balance, std::slice::from_ref(&half), node);
            // The middle of that half, which is surely no longer than the first.
            if let Some(known) = behind.get(behind.len() / 2).and_then(image) {
                path.mirrored = matches!(known, KnownMotion::Mirrored(_));
                // The first point beyond stays, so that the crossing lies between two points.
                path.nodes.truncate(index + 2);
                path.ends[1] = BranchEnd::Crossing;
                if is_begun_at_crossing {
                    path.ends[0] = BranchEnd::Crossing;
                }
                return;
            }
        }
        if is_begun_at_crossing {
            path.nodes.pop();
        }
    }

    /// The branch on which the motion of a point lies, shifted by drive periods or mirrored; `None`
    /// if there is none.
    pub(super) fn known_motion(
        &self,
        balance: &DrivenBalance,
        paths: &[BranchPath],
        node: &BranchNode,
    ) -> Option<KnownMotion> {
        match (&self.period_series, node.truth) {
            (Some(_), _) => self.known_orbit(balance, paths, node),
            // A motion from the map from jump to jump is compared by that.
            (None, Some(truth)) if self.driven.jumps() > 0 => {
                self.known_across_jumps(balance, paths, node, truth.start)
            }
            _ => self.known_coefficients(balance, paths, &node.coefficients, node.parameter),
        }
    }

    /// The branch of the balance on which a motion lies, as in [`Self::known_motion`].
    fn known_coefficients(
        &self,
        balance: &DrivenBalance,
        paths: &[BranchPath],
        coefficients: &DVector<f64>,
        parameter: f64,
    ) -> Option<KnownMotion> {
        /// Largest error of an interpolation between two points, relative to the size of the
        /// motion.
        const NEAR: f64 = 0.2;
        const SAME: f64 = 1e-5;
        let size = balance.core.extent(coefficients).max(1e-3 * coefficients[0].abs());
        let size = size.max(smallest(balance, paths));
        let period = std::f64::consts::TAU / self.question.periods as f64;
        let shifts = (0..self.question.periods).map(|periods| period * periods as f64);
        let shifted: Vec<DVector<f64>> =
            shifts.clone().map(|shift| balance.core.later(coefficients, shift)).collect();
        let mirrored: Vec<DVector<f64>> =
            shifts.map(|shift| -balance.core.later(coefficients, shift + 0.5 * period)).collect();
        // Positions a period of the force apart, such as a full turn of a pendulum, count as the
        // same.
        let is_one = |motion: &DVector<f64>, of: &[DVector<f64>], within: f64, anywhere: bool| {
            let near = |shifted: &DVector<f64>| {
                let apart = motion - shifted;
                let (mean, waves) = (apart[0], apart.rows(1, apart.len() - 1).norm());
                let allowed = within * size.max(balance.core.extent(motion));
                waves <= allowed
                    && (anywhere || mean.abs() <= allowed || self.repeats_after(mean, parameter))
            };
            of.iter().any(near)
        };
        let between = |pair: &[BranchNode], of: &[DVector<f64>]| {
            let [one, other] = pair else { return false };
            let Some(part) = one.part_of_way(other, parameter) else {
                return false;
            };
            let guess = &one.coefficients + (&other.coefficients - &one.coefficients) * part;
            let solved = || balance.solve(&guess, parameter);
            is_one(&guess, of, NEAR, true)
                && solved().is_some_and(|found| is_one(&found, of, SAME, false))
        };
        let on = |of: &[DVector<f64>]| {
            let holds = |path: &BranchPath| path.nodes.windows(2).any(|pair| between(pair, of));
            paths.iter().position(holds)
        };
        match on(&shifted) {
            Some(_) => Some(KnownMotion::Itself),
            None => on(&mirrored).map(KnownMotion::Mirrored),
        }
    }

    /// Whether the force is the same this far away.
    pub(super) fn repeats_after(&self, distance: f64, parameter: f64) -> bool {
        (0..8).all(|index| {
            let (x, v) = (0.37 * f64::from(index) - 1.1, 0.9 - 0.23 * f64::from(index));
            let force = |x: f64| self.driven.force(&[x, v, f64::from(index), parameter]);
            (force(x + distance) - force(x)).abs() <= 1e-4 * (force(x).abs() + force(x + 1.0).abs())
        })
    }

    /// Follows the branch that crosses another one here. Returns whether it consists of motions of
    /// every amplitude at this one value of the parameter.
    pub(super) fn follow_crossing(
        &self,
        balance: &DrivenBalance,
        walk: &ContinuationSettings,
        at: &BranchNode,
        paths: &mut Vec<BranchPath>,
    ) -> bool {
        if self.period_series.is_some() {
            let is_known = |node: &BranchNode| self.was_known(balance, paths, node);
            for path in self.shot_beside_crossing(balance, at, walk.size, is_known) {
                self.keep(balance, path, paths);
            }
            return false;
        }
        if at.truth.is_some() {
            self.follow_stuck_crossing(balance, at, walk.size, paths);
            return false;
        }
        let mut is_centre = false;
        for node in walk.crossing(balance, at) {
            if self.was_known(balance, paths, &node) {
                continue;
            }
            if let Some(path) =
                walk.branch_along(balance, &node.coefficients, node.parameter, &node.tangent)
            {
                is_centre |= self.is_centre(&path);
                self.keep(balance, path, paths);
            }
        }
        is_centre
    }

    /// Whether these are motions at one value of the parameter, as only an equation without drive
    /// and damping has.
    fn is_centre(&self, path: &BranchPath) -> bool {
        /// Relative difference, over the range, below which two parameters are equal.
        const NOTHING: f64 = 1e-9;
        let [low, high] = self.question.range;
        let first = path.nodes.first().map_or(low, |node| node.parameter);
        let moves = |node: &BranchNode| (node.parameter - first).abs() > NOTHING * (high - low);
        (self.driven.self_excited || self.driven.undamped) && !path.nodes.iter().any(moves)
    }
}

/// The size below which motions are compared as if they were as large: Newton's method ends at a
/// motion at rest with the rounding of its last step.
pub(super) fn smallest(balance: &DrivenBalance, paths: &[BranchPath]) -> f64 {
    const SMALLEST: f64 = 1e-3;
    SMALLEST * paths.iter().map(|path| largest(balance, path)).fold(0.0, f64::max)
}

/// The size of the largest motion of a branch, or of a typical one if the branch grows without
/// bound.
pub(super) fn largest(balance: &DrivenBalance, path: &BranchPath) -> f64 {
    continuation::largest(balance, &path.nodes, path.ends)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::ResponseRequest;

    /// The branches through the motions of a balance that are larger than this at a value of the parameter,
    /// each of one phase of the first harmonic, with the number of times that they pass a value near it.
    fn branches_at(
        equation: &str,
        range: [f64; 2],
        periods: usize,
        (at, amplitude): (f64, f64),
    ) -> Vec<(BranchPath, usize)> {
        const PHASES: u32 = 12;
        let question = ResponseRequest::new(equation, "w", range, "").expect("a request");
        let question = ResponseRequest { periods, ..question };
        let asked = PreparedRequest::new(&question, question.equations.oscillator().expect("one"))
            .expect("a request");
        let balance = DrivenBalance::new(&asked.driven, 8);
        let seed = |phase: u32| {
            let mut guess = DVector::zeros(balance.core.size());
            let (sine, cosine) =
                (std::f64::consts::TAU * f64::from(phase) / f64::from(PHASES)).sin_cos();
            (guess[1], guess[2]) = (amplitude * cosine, amplitude * sine);
            let found = balance.solve(&guess, at)?;
            let is_large = balance.core.extent(&found) > 0.7 * amplitude;
            is_large.then(|| asked.seed(&balance, &found, at))
        };
        let seeds: Vec<Seed> = (0..PHASES).filter_map(seed).collect();
        assert!(!seeds.is_empty());
        // A branch has a point at the value itself.
        let near = 1.0003 * at;
        let passes = |path: &BranchPath| {
            let passes =
                |pair: &[BranchNode]| (pair[0].parameter - near) * (pair[1].parameter - near) < 0.0;
            path.nodes.windows(2).filter(|pair| passes(pair)).count()
        };
        let branches = asked.branches(&balance, &seeds, amplitude, &[]).into_iter();
        branches.map(|path| (passes(&path), path)).map(|(count, path)| (path, count)).collect()
    }

    /// The large motion of a pendulum on a moving hinge goes through a crossing with a lopsided one, and
    /// through rest to the same motions a drive period later, which are not listed again.
    #[test]
    fn a_branch_goes_on_to_its_image_behind_another_crossing() {
        let equation = "x'' + x'/20 + (1 + 0.4*cos(w*t))*sin(x) = 0";
        let found = branches_at(equation, [1.39, 2.3], 2, (1.9, 1.4));
        let counts: Vec<usize> = found.iter().map(|(_, count)| *count).collect();
        assert_eq!(counts, [1]);
        let ends = found[0].0.ends;
        assert!(
            ends.contains(&BranchEnd::Crossing) && ends.contains(&BranchEnd::Range),
            "{ends:?}"
        );
    }

    /// An oscillation that three periods of a drive lock has six images of its stable and of its
    /// unstable phase, and one loop leads through all: it is closed behind the first two.
    #[test]
    fn a_loop_through_its_own_images_is_closed_at_the_first() {
        let equation = "x'' - (1 - x^2)*x'/5 + x = 0.6*cos(w*t)";
        let found = branches_at(equation, [2.97, 3.02], 3, (2.99, 2.0));
        let counts: Vec<usize> = found.iter().map(|(_, count)| *count).collect();
        assert_eq!(counts, [2]);
        assert_eq!(found[0].0.ends, [BranchEnd::Closed; 2]);
    }
}

//! Branches of orbits: through starts, through crossings with known ones, each once.

use std::f64::consts::TAU;

use nalgebra::DVector;
use num_complex::Complex;

use super::changes::changes_between;
use super::problem::{Anchor, CoupledProblem, Kind, Orbit, Orbits, SMALLEST, Travel};
use super::surfaces::largest;
use crate::expr::Expr;
use crate::numeric::orbit_branch::{OrbitBranchEnd, OrbitBranchLimits};
use crate::response::bifurcation::BifurcationKind;
use crate::response::continuation::BranchEnd;
use crate::response::{LONGEST_STEP, MOST_BRANCHES, MOST_IMPACTS, MOST_POINTS};
use crate::wall::Wall;

/// A branch of orbits in order.
#[derive(Clone, Debug)]
pub(super) struct OrbitBranch {
    pub(super) orbits: Vec<Orbit>,
    pub(super) ends: [BranchEnd; 2],
    /// Whether the mirror images of its orbits are others, which are not listed.
    pub(super) mirrored: bool,
    /// The beginning of its motions, where nothing drives them.
    pub(super) anchor: Anchor,
}

impl OrbitBranch {
    /// The stretches whose orbits begin at one phase.
    pub(super) fn runs(&self) -> impl Iterator<Item = &[Orbit]> {
        self.orbits.chunk_by(|one, other| one.kept.section == other.kept.section)
    }

    /// The orbits without those that are there a second time, at another phase.
    pub(super) fn distinct(&self) -> impl Iterator<Item = &Orbit> {
        let is_again =
            |index: usize| self.orbits[index - 1].kept.section != self.orbits[index].kept.section;
        let all = self.orbits.iter().enumerate();
        all.filter(move |(index, _)| *index == 0 || !is_again(*index)).map(|(_, orbit)| orbit)
    }

    /// The neighbouring orbits, each two of which begin at one phase.
    pub(super) fn pairs(&self) -> impl Iterator<Item = &[Orbit]> {
        self.runs().flat_map(|run| run.windows(2))
    }
}

/// A motion from which a branch may start.
#[derive(Clone, Debug)]
pub(super) struct Start {
    pub(super) parameter: f64,
    /// The state, then the period of a cycle.
    pub(super) unknowns: Vec<f64>,
    /// The phase of the drive at which that is the state.
    pub(super) section: f64,
}

/// All branches that are known, and the travel of the largest motions on them.
#[derive(Clone, Debug, Default)]
pub(super) struct Known {
    pub(super) branches: Vec<OrbitBranch>,
    pub(super) scale: Travel,
}

/// An orbit that lies on a known branch.
pub(super) struct Found {
    /// The index of the branch.
    pub(super) branch: usize,
    /// Whether it is the mirror image of the orbit there, and not this itself.
    pub(super) mirrored: bool,
}

impl Known {
    /// Adds a branch.
    fn push(&mut self, branch: OrbitBranch) {
        for orbit in &branch.orbits {
            self.scale.resize(orbit.kept.travel.len(), 0.0);
            for (scale, travel) in self.scale.iter_mut().zip(&orbit.kept.travel) {
                *scale = scale.max(*travel);
            }
        }
        self.branches.push(branch);
    }

    /// The travel of the largest motions, with one more.
    fn scale_with(&self, travel: &[f64]) -> Travel {
        let known = |index: usize| self.scale.get(index).copied().unwrap_or(0.0);
        travel.iter().enumerate().map(|(index, travel)| travel.max(known(index))).collect()
    }
}

/// The states of the images of a motion at one phase: of those shifted by periods of the drive, and of the mirrored
/// ones.
type Images = [Vec<Vec<f64>>; 2];

/// The factor of growth in a period beyond which no branch of self-excited motions is followed: a single shot, with
/// its errors so much enlarged, does not tell the other multipliers.
const MOST_GROWTH: f64 = 1e4;

impl CoupledProblem<'_> {
    /// Whether no more branches are followed.
    pub(super) fn is_done(&self, known: &Known) -> bool {
        known.branches.len() >= MOST_BRANCHES
            || self.is_exhausted()
            || self.question.interrupt.is_requested()
    }

    /// The orbit that Newton's method finds near a start, of a motion of its size; searched for
    /// twice where no size of a motion is known.
    pub(super) fn orbit_near(&self, start: &Start, scale: &[f64], anchor: Anchor) -> Option<Orbit> {
        let n = self.states.len();
        let guess = DVector::from_column_slice(&start.unknowns);
        let absolute: Vec<f64> = start.unknowns[..n].iter().map(|value| value.abs()).collect();
        let near = |guess: &DVector<f64>, travel: &[f64]| {
            let unknowns = guess.clone().push(start.parameter);
            let sizes = self.sizes(travel, scale, &unknowns);
            self.with_orbits(scale, anchor, |orbits| {
                orbits.orbit_at(guess, start.parameter, &sizes)
            })
        };
        let first = near(&guess, &absolute)?;
        if !scale.is_empty() || self.is_at_rest(&first) {
            return Some(first);
        }
        let guess = first.unknowns.rows(0, guess.len()).into_owned();
        near(&guess, &first.kept.travel)
    }

    /// The orbit near a start of a driven motion, at a phase without events nearby.
    pub(super) fn driven_orbit_near(&self, start: &Start, scale: &[f64]) -> Option<Orbit> {
        let start = self.away_from_events(start, scale);
        self.orbit_near(&start, scale, Anchor::at_phase(start.section))
    }

    /// Follows the branch through a start, unless it is known.
    pub(super) fn follow_from(&self, start: &Start, known: &mut Known) {
        if self.is_done(known) {
            return;
        }
        // Newton's method may come to a motion of another order of magnitude, whose period holds
        // hundreds of swings.
        const ENORMOUS: f64 = 100.0;
        let n = self.coordinates;
        let extent = |travel: &[f64]| travel.iter().take(n).copied().fold(0.0, f64::max);
        let Some(orbit) = self.driven_orbit_near(start, &known.scale) else { return };
        let largest = extent(&known.scale);
        if self.is_at_rest(&orbit) || self.creeps(&orbit) {
            return;
        }
        if largest > 0.0 && extent(&orbit.kept.travel) > ENORMOUS * largest {
            return;
        }
        if self.is_known(&orbit, known) {
            return;
        }
        self.push_branch(orbit, Anchor::NONE, known);
    }

    /// Follows the branch through an orbit and adds it. Where its motions turn out to be much larger
    /// than those known before, it is followed once more, with steps of their size.
    fn push_branch(&self, orbit: Orbit, anchor: Anchor, known: &mut Known) {
        const LARGER: f64 = 3.0;
        let n = self.coordinates;
        let extent = |travel: &[f64]| travel.iter().take(n).copied().fold(0.0, f64::max);
        let follow = |orbit: Orbit, scale: &[f64]| self.branch_through(orbit, scale, anchor);
        let scale = known.scale_with(&orbit.kept.travel);
        let branch = follow(orbit, &scale);
        let largest = branch
            .orbits
            .iter()
            .max_by(|one, other| extent(&one.kept.travel).total_cmp(&extent(&other.kept.travel)));
        let again = largest.filter(|orbit| {
            extent(&orbit.kept.travel) > LARGER * extent(&scale) && !self.is_exhausted()
        });
        let branch = match again.cloned() {
            Some(orbit) => {
                let scale = known.scale_with(&orbit.kept.travel);
                let longer = follow(orbit, &scale);
                self.down_to_rest(longer, branch)
            }
            None => branch,
        };
        let branch = self.cut_at_image(branch, &known.scale);
        if branch.orbits.is_empty() {
            return;
        }
        // Beside a crossing the orbit may lie before the first point of the branch that it belongs to.
        let middle = &branch.orbits[branch.orbits.len() / 2].clone();
        let [low, high] = self.question.range;
        let is_near =
            |bound: f64, orbit: &Orbit| (orbit.parameter() - bound).abs() <= 1e-9 * (high - low);
        let is_at_bound = [low, high]
            .iter()
            .any(|bound| branch.orbits.iter().all(|orbit| is_near(*bound, orbit)));
        if (branch.orbits.len() > 2 || is_at_bound) && self.is_known(middle, known) {
            return;
        }
        let again = self.reentries(&branch, &known.scale);
        known.push(branch);
        for orbit in again {
            self.add_branch(orbit, anchor, known);
        }
    }

    /// A branch of large cycles or free motions that ends where they are small, with the smaller ones of
    /// the same branch as it was followed by shorter steps.
    fn down_to_rest(&self, mut branch: OrbitBranch, small: OrbitBranch) -> OrbitBranch {
        let n = self.coordinates;
        let extent = |orbit: &Orbit| orbit.kept.travel[..n].iter().copied().fold(0.0, f64::max);
        let at_rest = |ends: &[BranchEnd; 2]| ends.iter().position(|end| *end == BranchEnd::Rest);
        let (Some(side), Some(begin)) = (at_rest(&branch.ends), at_rest(&small.ends)) else {
            return branch;
        };
        let last = branch.orbits.len() - 1;
        let least = extent(&branch.orbits[if side == 0 { 0 } else { last }]);
        // From rest on.
        let reverse = |orbits: Vec<Orbit>| -> Vec<Orbit> {
            orbits.into_iter().rev().map(Orbit::reversed).collect()
        };
        let growing = if begin == 0 { small.orbits } else { reverse(small.orbits) };
        let smaller: Vec<Orbit> =
            growing.into_iter().take_while(|orbit| extent(orbit) < least).collect();
        match side {
            0 => branch.orbits = smaller.into_iter().chain(branch.orbits).collect(),
            _ => branch.orbits.extend(reverse(smaller)),
        }
        branch
    }

    /// A branch up to the crossing beyond which its motions are images of those before, shifted by
    /// periods of the drive or mirrored.
    fn cut_at_image(&self, branch: OrbitBranch, scale: &[f64]) -> OrbitBranch {
        match self.kind {
            Kind::Driven(_) => self.cut_at_shifted(branch, scale),
            Kind::SelfExcited => self.cut_at_same(branch, scale),
            Kind::Free => branch,
        }
    }

    /// A branch of cycles up to the turn beyond which it has the same cycles, begun elsewhere, or their
    /// mirror images.
    fn cut_at_same(&self, mut branch: OrbitBranch, scale: &[f64]) -> OrbitBranch {
        let turns = |pair: &[Orbit]| pair[0].parameter_slope() * pair[1].parameter_slope() < 0.0;
        let Some(index) = branch.orbits.windows(2).position(turns) else { return branch };
        let ends = branch.ends;
        let mut halves = [branch.orbits[..=index].to_vec(), branch.orbits[index + 1..].to_vec()];
        let longer = usize::from(halves[1].len() > halves[0].len());
        let shorter = &halves[1 - longer];
        let middle = shorter[shorter.len() / 2].clone();
        let half = OrbitBranch {
            orbits: std::mem::take(&mut halves[longer]),
            ends: if longer == 0 {
                [ends[0], BranchEnd::Crossing]
            } else {
                [BranchEnd::Crossing, ends[1]]
            },
            ..branch.clone()
        };
        let known = Known { branches: vec![half], scale: scale.to_vec() };
        if let Some(Found { mirrored, .. }) = self.find(&middle, &known) {
            let [half] = known.branches.try_into().unwrap_or_else(|_| [branch.clone()]);
            branch = OrbitBranch { mirrored: branch.mirrored || mirrored, ..half };
        }
        branch
    }

    /// A branch of driven motions up to the crossing beyond which its motions are images of those
    /// before, or between two of them.
    fn cut_at_shifted(&self, mut branch: OrbitBranch, scale: &[f64]) -> OrbitBranch {
        let crossing = |index: usize| {
            let [from, to] = [&branch.orbits[index - 1], &branch.orbits[index]];
            if from.parameter_slope() * to.parameter_slope() >= 0.0 {
                return None;
            }
            // One of the two may lie on the crossing itself, where it is its own image.
            let before = [index - 1, index.saturating_sub(2)];
            let behind = [index, (index + 1).min(branch.orbits.len() - 1)];
            let mut pairs = before.into_iter().flat_map(|one| behind.map(|other| (one, other)));
            let by_mirror = pairs.find_map(|(one, other)| {
                self.image_of(&branch.orbits[one], &branch.orbits[other], scale)
            })?;
            Some((index, by_mirror))
        };
        let crossings: Vec<(usize, bool)> =
            (1..branch.orbits.len()).filter_map(crossing).take(2).collect();
        match crossings[..] {
            [] => {}
            // The longer part has all motions.
            [(index, by_mirror)] => {
                if index > branch.orbits.len() / 2 {
                    branch.orbits.truncate(index);
                    branch.ends[1] = BranchEnd::Crossing;
                } else {
                    branch.orbits.drain(..index);
                    branch.ends[0] = BranchEnd::Crossing;
                }
                branch.mirrored |= by_mirror;
            }
            [(from, one), (to, other), ..] => {
                branch.orbits.truncate(to);
                branch.orbits.drain(..from);
                branch.ends = [BranchEnd::Crossing; 2];
                branch.mirrored |= one || other;
            }
        }
        branch
    }

    /// Whether an orbit is about the mirror image of another one near it, or that orbit shifted by
    /// periods of the drive; `None` if it is neither.
    fn image_of(&self, from: &Orbit, to: &Orbit, scale: &[f64]) -> Option<bool> {
        let [shifted, mirrored] = self.images(from, to.kept.section, scale)?;
        let sizes = self.state_sizes(&from.kept.travel, scale);
        let apart = |one: &Vec<f64>| {
            let each = one.iter().zip(to.unknowns.iter()).zip(&sizes);
            each.map(|((one, other), size)| ((one - other) / size).abs()).fold(0.0, f64::max)
        };
        let nearest = |images: &[Vec<f64>]| images.iter().map(apart).fold(f64::MAX, f64::min);
        let (by_shift, by_mirror) = (nearest(&shifted[1..]), nearest(&mirrored));
        (by_shift.min(by_mirror) <= 0.5 * apart(&shifted[0])).then_some(by_mirror < by_shift)
    }

    /// The orbits at which a branch that leaves the range comes back into it.
    fn reentries(&self, branch: &OrbitBranch, scale: &[f64]) -> Vec<Orbit> {
        /// Largest number of points beyond the range.
        const MOST: usize = 100;
        /// Ratio to the lowest frequency of the range below which no motion is followed, as of a single coordinate:
        /// towards zero a period takes ever longer, with a resonance at every part of a natural frequency.
        const LEAST_FREQUENCY: f64 = 0.25;
        let [low, high] = self.question.range;
        let width = high - low;
        let least = LEAST_FREQUENCY * self.frequency_at(low).min(self.frequency_at(high));
        let is_slow = |orbit: &Orbit| {
            matches!(self.kind, Kind::Driven(_)) && self.frequency_of(orbit) < least
        };
        let limits = OrbitBranchLimits {
            range: [low - 0.5 * width, high + 0.5 * width],
            longest: 2.0 * LONGEST_STEP,
            most: MOST,
            interrupt: self.question.interrupt,
        };
        let ends = [branch.orbits.first(), branch.orbits.last()].into_iter().zip(branch.ends);
        let outward: Vec<Orbit> = ends
            .enumerate()
            .filter(|(_, (_, end))| *end == BranchEnd::Range)
            .filter_map(|(side, (orbit, _))| {
                let orbit = orbit?.clone();
                Some(if side == 0 { orbit.reversed() } else { orbit })
            })
            .collect();
        let back = |orbits: &Orbits, pair: &[Orbit]| {
            let [from, to] = pair else { return None };
            let inside = from.parameter().clamp(low, high);
            let part = (inside - from.parameter()) / (to.parameter() - from.parameter());
            if from.parameter() == inside || !(0.0..=1.0).contains(&part) {
                return None;
            }
            let guess = &from.unknowns + (&to.unknowns - &from.unknowns) * part;
            let guess = guess.rows(0, guess.len() - 1).into_owned();
            orbits.orbit_at(&guess, inside, &(orbits.sizes)(from))
        };
        let mut found = Vec::new();
        for start in outward {
            self.with_orbits(scale, branch.anchor.of_orbit(&start), |orbits| {
                let (beyond, _) = orbits.follow(start, &limits, &is_slow);
                found.extend(beyond.windows(2).find_map(|pair| back(orbits, pair)));
            });
        }
        found
    }

    /// Whether an orbit lies on a known branch; marks the branch if it is a mirror image.
    pub(super) fn is_known(&self, orbit: &Orbit, known: &mut Known) -> bool {
        let found = self.find(orbit, known);
        if let Some(Found { branch, mirrored: true }) = found {
            known.branches[branch].mirrored = true;
        }
        found.is_some()
    }

    /// The branch through an orbit, both ways, in the range of the request.
    fn branch_through(&self, orbit: Orbit, scale: &[f64], anchor: Anchor) -> OrbitBranch {
        const ENORMOUS: f64 = 1e4;
        let n = self.coordinates;
        let extent = |travel: &[f64]| travel[..n].iter().copied().fold(0.0, f64::max);
        let ordinary = scale.get(..n).map_or(0.0, extent);
        let bound = ENORMOUS * extent(&orbit.kept.travel).max(ordinary);
        /// The number of states up to which the longest step is that of one coordinate; beyond it a step of each of
        /// them is as long as with this number.
        const FEW: usize = 8;
        let many = (self.states.len().max(FEW) as f64 / FEW as f64).sqrt();
        let limits = OrbitBranchLimits {
            range: self.question.range,
            longest: LONGEST_STEP * many,
            most: MOST_POINTS,
            interrupt: self.question.interrupt,
        };
        let is_cycle = matches!(self.kind, Kind::SelfExcited | Kind::Free);
        // A branch of cycles or of free motions ends at rest, near a Hopf point or a linear mode.
        const AT_REST: f64 = 0.02;
        // No step leads over rest to the mirror images.
        const STEPS: f64 = 1.5;
        let own = extent(&orbit.kept.travel);
        let step = LONGEST_STEP * SMALLEST * ordinary;
        let least = (AT_REST * own).max((STEPS * step).min(0.5 * own));
        let refused = |orbit: &Orbit| {
            let extent = extent(&orbit.kept.travel);
            self.is_at_rest(orbit)
                || self.growth_in_period(orbit) > MOST_GROWTH
                || self.creeps(orbit)
                || extent > bound
                || is_cycle && extent < least
                || self.is_exhausted()
        };
        let follow = |orbit| self.follow_past_events(orbit, &limits, scale, anchor, &refused);
        let (mut points, end) = follow(orbit.clone());
        let ends = match end {
            OrbitBranchEnd::Closed => [end; 2],
            end => {
                let (before, first) = follow(orbit.reversed());
                let before = before.into_iter().skip(1).rev().map(Orbit::reversed);
                points = before.chain(points).collect();
                [first, end]
            }
        };
        let last = [points.first(), points.last()];
        let at_wall = |side: usize| last[side].and_then(|orbit| self.end_at_wall(orbit));
        let ends = [0, 1].map(|side| match ends[side] {
            OrbitBranchEnd::Range => BranchEnd::Range,
            OrbitBranchEnd::Closed => BranchEnd::Closed,
            OrbitBranchEnd::Joined => BranchEnd::Crossing,
            OrbitBranchEnd::Lost => at_wall(side).unwrap_or(BranchEnd::Lost),
            OrbitBranchEnd::Points => BranchEnd::Points,
            OrbitBranchEnd::Refused if self.is_exhausted() => BranchEnd::Points,
            OrbitBranchEnd::Refused if self.rests.get() => BranchEnd::Held,
            OrbitBranchEnd::Refused
                if last[side]
                    .is_some_and(|point| self.growth_in_period(point) > 0.1 * MOST_GROWTH) =>
            {
                BranchEnd::Sensitive
            }
            OrbitBranchEnd::Refused
                if last[side].is_some_and(|point| !point.kept.encounters.places.is_empty()) =>
            {
                BranchEnd::Lost
            }
            OrbitBranchEnd::Refused => match last[side] {
                Some(point) if extent(&point.kept.travel) < 0.1 * bound => BranchEnd::Rest,
                _ => BranchEnd::Unbounded,
            },
            OrbitBranchEnd::Interrupted => BranchEnd::Interrupted,
        });
        // A start on a bound of the range may be followed away from it.
        let [low, high] = limits.range;
        let rounding = 1e-9 * (high - low);
        points.retain(|orbit| (low - rounding..=high + rounding).contains(&orbit.parameter()));
        OrbitBranch { orbits: points, ends, mirrored: false, anchor }
    }

    /// The factor by which a disturbance of a self-excited motion grows in a period, 0 if it is not known; of other
    /// motions it does not end a branch.
    fn growth_in_period(&self, orbit: &Orbit) -> f64 {
        match self.kind {
            Kind::SelfExcited => self.multipliers(orbit).map_or(0.0, |all| {
                all.iter().map(|multiplier| multiplier.norm()).fold(0.0, f64::max)
            }),
            Kind::Driven(_) | Kind::Free => 0.0,
        }
    }

    /// Whether something that friction holds but for a moment is pushed on in it, a little each period: at
    /// the edge of the places where it would be held, along which no branch is followed.
    pub(super) fn creeps(&self, orbit: &Orbit) -> bool {
        const NEARLY_ALL: f64 = 0.99;
        const NEAR_ONE: f64 = 1e-4;
        let near_one = |value: &Complex<f64>| (value - Complex::from(1.0)).norm() < NEAR_ONE;
        orbit.kept.encounters.stuck > NEARLY_ALL
            && self.multipliers(orbit).is_some_and(|all| all.iter().any(near_one))
    }

    /// The reason why a branch ends at an orbit, if it has to do with a wall.
    fn end_at_wall(&self, orbit: &Orbit) -> Option<BranchEnd> {
        /// Size of a gap, or of the speed of an impact, relative to those of the motion, near a wall.
        const NEAR: f64 = 0.02;
        const SLOW: f64 = 0.1;
        if !self.question.has_jumps_of_states() {
            return None;
        }
        let flow = self.in_phase.as_ref().unwrap_or(&self.in_time);
        let sizes = self.state_sizes(&orbit.kept.travel, &[]);
        let start = &orbit.start()[..self.states.len()];
        if flow.least_gap(start, orbit.kept.section, orbit.parameter(), &sizes) < NEAR * NEAR {
            return Some(BranchEnd::ImpactAtStart);
        }
        if orbit.kept.encounters.slowest < SLOW {
            return Some(BranchEnd::Grazing);
        }
        const PLACES: usize = 256;
        /// Part of the period about an impact or event within which a small gap is that of it.
        const ABOUT: f64 = 0.02;
        let period = std::f64::consts::TAU / self.frequency_of(orbit);
        let begin = self.time_of_section(orbit);
        let path = self.by_series(start, [begin, period], orbit.parameter())?;
        let numbers = [(self.question.parameter, orbit.parameter())];
        let is_of_event = |part: f64| {
            let parts = orbit.kept.encounters.times.iter().map(|time| match self.kind {
                Kind::Driven(_) => (time - orbit.kept.section) / TAU,
                Kind::SelfExcited | Kind::Free => time / period,
            });
            { parts }.any(|own| {
                let apart = own - part;
                (apart - apart.round()).abs() < ABOUT
            })
        };
        let is_near = |index: usize| {
            let part = index as f64 / PLACES as f64;
            if is_of_event(part) {
                return false;
            }
            let time = period * part;
            let Some(states) = path.states_at(time) else { return false };
            let mut values: std::collections::BTreeMap<_, _> =
                self.states.iter().copied().zip(states.iter().copied()).chain(numbers).collect();
            values.insert(crate::symbol::Symbol::new("t"), begin + time);
            let size = sizes[..self.coordinates].iter().copied().fold(0.0, f64::max);
            let is_near =
                |gap: &Expr| gap.evaluate(&values).is_ok_and(|gap| gap.abs() < NEAR * size);
            let walls = self.walls.iter().map(|wall| &wall.gap);
            walls.chain(self.events.iter().map(|event| &event.guard)).any(is_near)
        };
        (0..PLACES).any(is_near).then_some(BranchEnd::Grazing)
    }

    /// The start of an orbit, and that behind an event at its beginning.
    fn starts_at_wall(&self, orbit: &Orbit) -> Vec<Start> {
        let flow = self.in_phase.as_ref().unwrap_or(&self.in_time);
        let start = orbit.start()[..self.states.len()].to_vec();
        let (section, parameter) = (orbit.kept.section, orbit.parameter());
        let behind = flow.behind_event(&start, section, parameter);
        let all = [Some(start), behind].into_iter().flatten();
        all.map(|unknowns| Start { parameter, unknowns, section }).collect()
    }

    /// Whether the mirror image of every wall is a wall, so that the mirror image of a motion is one; with
    /// other events that is not looked for.
    fn walls_are_mirrored(&self) -> bool {
        let mirror = self.states[..self.coordinates].iter().map(|name| (*name, -Expr::from(*name)));
        let mirror = mirror.collect();
        self.events.is_empty()
            && self.walls.iter().all(|wall| {
                let Ok(gap) = wall.gap.substitute_all(&mirror) else { return false };
                let same =
                    |other: &Wall| (&gap - &other.gap).expand().is_ok_and(|apart| apart.is_zero());
                let mut others = self.walls.iter();
                !gap.contains(crate::symbol::Symbol::new("t"))
                    && others.any(|other| other.restitution == wall.restitution && same(other))
            })
    }

    /// Follows the branches on the other side of the grazing at which known ones end, where there is an
    /// impact less or more.
    pub(super) fn follow_beyond_grazings(&self, known: &mut Known) {
        /// Distances from a grazing at which motions are looked for, in parts of the range.
        const BESIDE: [f64; 4] = [1e-4, -1e-4, 4e-3, -4e-3];
        let [low, high] = self.question.range;
        let mut index = 0;
        while index < known.branches.len() {
            let branch = known.branches[index].clone();
            let ends = [branch.orbits.first(), branch.orbits.last()].into_iter().zip(branch.ends);
            let is_at_wall =
                |end: &BranchEnd| matches!(end, BranchEnd::Grazing | BranchEnd::ImpactAtStart);
            for (orbit, _) in ends.filter(|(_, end)| is_at_wall(end)) {
                let most = MOST_IMPACTS * self.question.periods;
                let has_few = |orbit: &&Orbit| {
                    orbit.kept.encounters.counts().into_iter().sum::<usize>() <= most
                };
                let Some(orbit) = orbit.filter(has_few) else { continue };
                for part in BESIDE {
                    let parameter = orbit.parameter() + part * (high - low);
                    if (low..=high).contains(&parameter) {
                        for start in self.starts_at_wall(orbit) {
                            self.follow_from(&Start { parameter, ..start }, known);
                        }
                    }
                }
            }
            index += 1;
        }
    }

    /// Leaves out the branches that lie on others: where one ends at a corner or a grazing, another that was found
    /// later may come through it.
    pub(super) fn without_parts(&self, known: &mut Known) {
        let mut index = 0;
        while index < known.branches.len() {
            let branch = &known.branches[index];
            let [first, last] = branch.ends.map(|end| {
                matches!(end, BranchEnd::Lost | BranchEnd::Grazing | BranchEnd::ImpactAtStart)
            });
            let count = branch.orbits.len();
            let is_over = self.question.interrupt.is_requested() || self.is_exhausted();
            if !(first || last) || count < 4 || is_over {
                index += 1;
                continue;
            }
            let branch = known.branches.remove(index);
            // At the corner itself no orbit may be found.
            let begin = if first { count / 4 } else { 0 };
            let end = if last { 3 * count / 4 } else { count - 1 };
            let mut on = [begin, count / 2, end].into_iter().map(|place| {
                let found = self.find(&branch.orbits[place], known)?;
                (!found.mirrored).then_some(found.branch)
            });
            let first = on.next().flatten();
            if first.is_some() && on.all(|other| other == first) {
                continue;
            }
            known.branches.insert(index, branch);
            index += 1;
        }
    }

    /// Follows the branches that cross known ones, until there are no more.
    pub(super) fn follow_crossings(&self, known: &mut Known) {
        let mut index = 0;
        while index < known.branches.len() {
            let branch = known.branches[index].clone();
            for pair in branch.pairs() {
                let [from, to] = pair else { continue };
                if from.orientation == to.orientation || self.is_done(known) {
                    continue;
                }
                let scale = known.scale.clone();
                let beside = self.with_orbits(&scale, branch.anchor.of_orbit(from), |orbits| {
                    let found = changes_between(self, orbits, from, to);
                    let mut crossings =
                        found.into_iter().filter(|(kind, _)| *kind == BifurcationKind::BranchPoint);
                    crossings.next().map(|(_, at)| orbits.beside_crossing(&at)).unwrap_or_default()
                });
                for orbit in beside {
                    if self.is_done(known) || self.is_known(&orbit, known) {
                        continue;
                    }
                    self.push_branch(orbit, branch.anchor, known);
                }
            }
            index += 1;
        }
    }

    /// Adds a branch through an orbit of free motions or cycles, unless it is known.
    pub(super) fn add_branch(&self, orbit: Orbit, anchor: Anchor, known: &mut Known) {
        let is_sensitive = self.growth_in_period(&orbit) > MOST_GROWTH;
        if is_sensitive || self.is_done(known) || self.is_known(&orbit, known) {
            return;
        }
        self.push_branch(orbit, anchor, known);
    }

    /// The states in which an orbit passes a phase in each drive period, and those of its mirror images, half a
    /// period of the drive later. A motion that nothing drives may begin anywhere on itself: its only image is the
    /// mirrored one.
    fn images(&self, orbit: &Orbit, section: f64, scale: &[f64]) -> Option<Images> {
        let start = self.state_at_phase(orbit, section, scale)?;
        let negative = |state: Vec<f64>| state.into_iter().map(|value| -value).collect();
        match self.kind {
            Kind::Driven(_) => {
                let periods = self.question.periods;
                let half = TAU / (2 * periods) as f64;
                let mut states = vec![start];
                for index in 1..2 * periods {
                    let phases = [index - 1, index].map(|index| section + half * index as f64);
                    let next = self.after(states.last()?, phases, orbit.parameter(), scale)?;
                    states.push(next);
                }
                let (mut shifted, mut mirrored) = (Vec::new(), Vec::new());
                let has_mirror = self.walls_are_mirrored();
                for (index, state) in states.into_iter().enumerate() {
                    match index % 2 {
                        0 => shifted.push(state),
                        _ if has_mirror => mirrored.push(negative(state)),
                        _ => {}
                    }
                }
                Some([shifted, mirrored])
            }
            Kind::SelfExcited | Kind::Free => {
                let mirror = negative(start.clone());
                Some([vec![start], vec![mirror]])
            }
        }
    }

    /// Whether an orbit passes a state, with the accuracy of a polygon of its points.
    fn passes(&self, orbit: &Orbit, state: &[f64], sizes: &[f64]) -> bool {
        const CORNERS: usize = 256;
        const NEAR: f64 = 2e-3;
        let n = self.states.len();
        let period = std::f64::consts::TAU / self.frequency_of(orbit);
        let start = &orbit.unknowns.as_slice()[..n];
        let times = [self.time_of_section(orbit), period];
        let Some(path) = self.by_series(start, times, orbit.parameter()) else { return false };
        let corner = |index: usize| -> Option<DVector<f64>> {
            let states = path.states_at(period * index as f64 / CORNERS as f64)?;
            let away = states.iter().zip(state).zip(sizes);
            Some(DVector::from_iterator(n, away.map(|((one, other), size)| (one - other) / size)))
        };
        let corners: Vec<DVector<f64>> = (0..=CORNERS).filter_map(corner).collect();
        corners.windows(2).any(|pair| {
            let way = &pair[1] - &pair[0];
            let length = way.norm_squared();
            let part =
                if length > 0.0 { (-pair[0].dot(&way) / length).clamp(0.0, 1.0) } else { 0.0 };
            (&pair[0] + way * part).norm() <= NEAR
        })
    }

    /// The known branch on which an orbit lies, shifted by drive periods or mirrored; `None` if there
    /// is none.
    pub(super) fn find(&self, orbit: &Orbit, known: &Known) -> Option<Found> {
        /// Largest error of an interpolation between two orbits, and largest difference of equal
        /// motions, relative to their sizes.
        const NEAR: f64 = 0.25;
        const SAME: f64 = 1e-5;
        let (n, parameter) = (self.states.len(), orbit.parameter());
        // The images of the orbit, at the phases at which known ones begin.
        let mut images: Vec<(f64, Option<Images>)> = Vec::new();
        let sizes = self.state_sizes(&orbit.kept.travel, &known.scale);
        let apart = |one: &[f64], other: &[f64]| {
            let each = one.iter().zip(other).zip(&sizes).enumerate();
            let each = each.map(|(index, ((one, other), size))| {
                let way = one - other;
                let turns = if self.angles.contains(&index) { (way / TAU).round() } else { 0.0 };
                ((way - TAU * turns) / size).abs()
            });
            each.fold(0.0, f64::max)
        };
        // Cycles may begin anywhere on themselves: they are compared by travel and period.
        let by_travel = matches!(self.kind, Kind::SelfExcited | Kind::Free);
        // A motion that dry friction holds at a place has its mirror image at another.
        let signs: &[f64] =
            if orbit.kept.encounters.places.is_empty() { &[1.0] } else { &[1.0, -1.0] };
        for (branch, path) in known.branches.iter().enumerate() {
            let pairs = path.pairs();
            for (pair, sign) in pairs.flat_map(|pair| signs.iter().map(move |sign| (pair, *sign))) {
                let [from, to] = pair else { continue };
                let way = to.parameter() - from.parameter();
                let part = if way == 0.0 { 0.0 } else { (parameter - from.parameter()) / way };
                if !(-1e-9..=1.0 + 1e-9).contains(&part) {
                    continue;
                }
                let section = from.kept.section;
                let is_here = |(own, _): &&(f64, _)| *own == section;
                if !images.iter().any(|own| is_here(&own)) {
                    images.push((section, self.images(orbit, section, &known.scale)));
                }
                let here = images.iter().find(is_here).and_then(|(_, images)| images.as_ref());
                let Some([shifted, mirrored]) = here else { continue };
                let mut guess = &from.unknowns + (&to.unknowns - &from.unknowns) * part;
                let count = guess.len() - 1;
                // Where dry friction holds a motion it may hold it at another place.
                for factors in &orbit.kept.encounters.places {
                    let of_place = |state: &[f64]| -> f64 {
                        state.iter().zip(factors).map(|(value, factor)| value * factor).sum()
                    };
                    let wanted = sign * of_place(orbit.start());
                    guess[largest(factors)] += wanted - of_place(guess.as_slice());
                }
                let is_near = |images: &[Vec<f64>]| {
                    images.iter().any(|image| apart(&guess.as_slice()[..n], image) <= NEAR)
                };
                let mixed: Vec<f64> = from
                    .kept
                    .travel
                    .iter()
                    .zip(&to.kept.travel)
                    .map(|(one, other)| one + part * (other - one))
                    .collect();
                let candidates = match by_travel {
                    true => apart(&mixed, &orbit.kept.travel) <= NEAR,
                    false => is_near(shifted) || is_near(mirrored),
                };
                if !candidates {
                    continue;
                }
                let all = self.sizes(&mixed, &known.scale, &guess);
                let start =
                    (&guess + aside_of_chord(from, to, part, &all)).rows(0, count).into_owned();
                let solved = self.with_orbits(&known.scale, path.anchor.of_orbit(from), |orbits| {
                    orbits.orbit_at(&start, parameter, &all)
                });
                let Some(solved) = solved else { continue };
                let there = &solved.unknowns.as_slice()[..n];
                let is_one =
                    |images: &[Vec<f64>]| images.iter().any(|image| apart(there, image) <= SAME);
                if by_travel {
                    // A cycle may be passed several times in the period.
                    let turns = orbit.unknowns[n] / solved.unknowns[n];
                    let same_period = matches!(self.kind, Kind::Free)
                        || turns > 0.5 && (turns - turns.round()).abs() <= SAME * turns;
                    if !same_period {
                        continue;
                    }
                    if self.passes(&solved, &shifted[0], &sizes) {
                        return Some(Found { branch, mirrored: false });
                    }
                    if self.passes(&solved, &mirrored[0], &sizes) {
                        return Some(Found { branch, mirrored: true });
                    }
                    continue;
                }
                if is_one(shifted) {
                    return Some(Found { branch, mirrored: false });
                }
                if is_one(mirrored) {
                    return Some(Found { branch, mirrored: true });
                }
            }
        }
        None
    }
}

/// The way from the chord between two neighbouring orbits to the cubic in the parameter with their tangents, at a
/// part of the way; zero beside a fold, where the branch is no function of the parameter. In: both orbits, the
/// part, and the sizes of the unknowns.
fn aside_of_chord(from: &Orbit, to: &Orbit, part: f64, sizes: &DVector<f64>) -> DVector<f64> {
    /// Largest distance of the cubic from the chord, in the length of the chord.
    const FARTHEST: f64 = 0.25;
    let chord = &to.unknowns - &from.unknowns;
    let way = to.parameter() - from.parameter();
    // The changes of the unknowns at the rates of both ends, beyond that along the chord.
    let beyond = |orbit: &Orbit| &orbit.tangent * (way / orbit.parameter_slope()) - &chord;
    let rest = 1.0 - part;
    let aside = (beyond(from) * rest - beyond(to) * part) * (part * rest);
    let length = |way: &DVector<f64>| way.component_div(sizes).norm();
    match length(&aside) <= FARTHEST * length(&chord) {
        true => aside,
        false => DVector::zeros(chord.len()),
    }
}

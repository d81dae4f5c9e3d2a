//! A request with its equation compiled, and its answer: branches through the initial motions, each
//! point judged, bifurcations between the points.
//!
//! In: a [`ResponseRequest`]. Out: a [`ResponseDiagram`] with as many harmonics as it takes, or by the
//! map of a period.

use std::cell::Cell;
use std::collections::BTreeMap;

use super::backbone::{BackbonePoint, backbones};
use super::balance::DrivenBalance;
use super::bifurcation::{self, BifurcationKind};
use super::branches::largest;
use super::continuation::{BranchEnd, BranchNode, BranchPath, ContinuationSettings};
use super::driven::Driven;
use super::judgement::PointJudgement;
use super::ripple::{self, LocatedBifurcation, Ripple};
use super::seeds::{InitialMotions, Seed, size_of};
use super::series::PeriodSeries;
use super::stability::SimulationBudget;
use super::{
    Bifurcation, Branch, Elsewhere, LONGEST_STEP, MOST_BRANCHES, MOST_EVALUATIONS, MOST_HARMONICS,
    MOST_POINTS, ResponseDiagram, ResponseError, ResponseRequest, SeedSearch,
};
use crate::expr::Expr;
use crate::oscillator::Oscillator;
use crate::symbol::Symbol;
use crate::trajectory::by_sides;
use crate::verify::Verdict;

/// A request with its equation compiled.
pub(super) struct PreparedRequest<'a> {
    pub(super) question: &'a ResponseRequest,
    /// The equation with all values but one.
    pub(super) oscillator: Oscillator,
    pub(super) driven: Driven,
    /// The map of a period, if branches are found by shooting.
    pub(super) period_series: Option<PeriodSeries>,
    /// Progress of the search for initial motions.
    pub(super) tried: Cell<SeedSearch>,
}

impl<'a> PreparedRequest<'a> {
    pub(super) fn new(
        question: &'a ResponseRequest,
        oscillator: &Oscillator,
    ) -> Result<Self, ResponseError> {
        let parameter = &question.parameter;
        let known = &oscillator.parameters;
        let self_excited = !oscillator.force.contains(Symbol::new("t"));
        if self_excited && oscillator.parts().is_ok_and(|parts| parts.damping.is_zero()) {
            return Err(ResponseError::NoDrive);
        }
        if self_excited && question.periods != 1 {
            return Err(ResponseError::NoPeriods(question.periods));
        }
        question.check_values_but(known, Some(*parameter))?;
        let values: BTreeMap<Symbol, Expr> = question.values.split(known).0;
        let oscillator = oscillator.with_values(&values)?;
        let force = by_sides(&oscillator.force, oscillator.coordinate, &BTreeMap::new())?;
        let oscillator = Oscillator { force, ..oscillator };
        let driven = Driven::new(&oscillator, *parameter, question.periods)?;
        if driven.self_excited && driven.undamped {
            return Err(ResponseError::NoDrive);
        }
        // A number of harmonics is a wish for a balance of so many.
        let shot = question.harmonics.is_none()
            && !driven.smooth
            && driven.jumps() == 0
            && !driven.self_excited
            && !driven.undamped;
        let period_series = shot.then(|| PeriodSeries::new(&driven)).flatten();
        let asked = Self { question, oscillator, driven, period_series, tried: Cell::default() };
        asked.has_frequency()
    }

    /// Whether something drives the motion, and its force jumps where it comes to places, whatever the velocity
    /// there, and nowhere else.
    pub(super) fn has_steps_in_place(
        question: &'a ResponseRequest,
        oscillator: &Oscillator,
    ) -> bool {
        let Ok(Self { driven, .. }) = Self::new(question, oscillator) else {
            return false;
        };
        let is_place = |index: usize| driven.normal(index)[1] == 0.0;
        !driven.self_excited && driven.jumps() > 0 && (0..driven.jumps()).all(is_place)
    }

    /// The backbones up to an amplitude a little above that of a response.
    pub(super) fn backbones(
        &self,
        amplitude: f64,
    ) -> Result<Vec<Vec<BackbonePoint>>, ResponseError> {
        let by_series = !self.driven.is_balanced();
        let how = (MOST_HARMONICS, by_series || self.period_series.is_some());
        backbones(&self.oscillator, &self.driven, how, self.question.range, 1.15 * amplitude)
    }

    /// The response by shooting: harmonics are only output.
    pub(super) fn shot_response(&self) -> Result<ResponseDiagram, ResponseError> {
        let InitialMotions { seeds, elsewhere, branches, gaps, .. } = self.seeds(MOST_HARMONICS)?;
        let mut response = self.attempt(MOST_HARMONICS, &seeds, &branches)?.with_sparse(gaps);
        response.elsewhere.extend(elsewhere);
        Elsewhere::sort(&mut response.elsewhere);
        self.follow_further(&mut response.elsewhere);
        Ok(response)
    }

    /// The response by harmonic balance, with as many harmonics as it takes, or by the map of a
    /// period from jump to jump.
    pub(super) fn balanced_response(&self) -> Result<ResponseDiagram, ResponseError> {
        const FIRST: usize = 8;
        // For the map of a period harmonics are only output, so that the largest number costs nothing.
        let automatic = match self.driven.is_balanced() {
            true => FIRST,
            false => MOST_HARMONICS,
        };
        let found = self.seeds(self.question.harmonics.unwrap_or(automatic))?;
        let InitialMotions { seeds, elsewhere, branches, harmonics: first, gaps } = found;
        let mut harmonics = first;
        let mut before = (f64::INFINITY, usize::MAX);
        let mut fewer: Option<ResponseDiagram> = None;
        loop {
            // The search has followed branches with the first number of harmonics.
            let known = if harmonics == first { &branches[..] } else { &[] };
            let attempt = self.attempt(harmonics, &seeds, known);
            let may_have_more =
                self.question.harmonics.is_none() && 2 * harmonics <= MOST_HARMONICS;
            if matches!(attempt, Err(ResponseError::NotFollowed { .. }))
                && may_have_more
                && fewer.is_none()
            {
                harmonics *= 2;
                continue;
            }
            // If the computation is interrupted on the way to more harmonics, the result with fewer of
            // them is the answer.
            let mut response = match (attempt, fewer.take()) {
                (Ok(response), None) => response,
                (Ok(response), Some(_)) if response.complete => response,
                (_, Some(response)) => ResponseDiagram { complete: false, ..response },
                (Err(error), None) => return Err(error),
            };
            let points: usize = response.branches.iter().map(|branch| branch.points.len()).sum();
            let judged = 100 * response.unjudged <= points;
            let resolved = !response.ends_with(BranchEnd::Harmonics);
            let followed = response.elsewhere.is_empty();
            let good = resolved
                && judged
                && followed
                && response.error.is_some_and(|error| error <= 0.1 * self.question.tolerance);
            // An error that more harmonics do not reduce has another cause, such as a jump of the
            // force.
            let now = (response.error.unwrap_or(f64::INFINITY), response.unjudged);
            let stalled = resolved && followed && now.0 >= 0.7 * before.0 && now.1 >= before.1;
            // Without a branch there is no error either.
            before = if followed { now } else { (f64::INFINITY, usize::MAX) };
            let fixed = self.question.harmonics.is_some() || !response.complete;
            let last = fixed || good || stalled || 2 * harmonics > MOST_HARMONICS;
            if last {
                response.elsewhere.extend(elsewhere);
                Elsewhere::sort(&mut response.elsewhere);
                self.follow_further(&mut response.elsewhere);
                let response = response.with_sparse(gaps);
                return match response.self_excited {
                    true => self.without_tails(response),
                    false => Ok(response),
                };
            }
            harmonics *= 2;
            fewer = Some(response);
        }
    }

    /// Checks that the frequency of the drive is positive in all of the range.
    fn has_frequency(self) -> Result<Self, ResponseError> {
        let (parameter, [low, high]) = (self.question.parameter, self.question.range);
        for part in 0..=20 {
            let at = low + (high - low) * f64::from(part) / 20.0;
            let value = self.driven.frequency_at(at);
            if !(value > 0.0 && value.is_finite()) {
                return Err(ResponseError::Frequency {
                    frequency: self.driven.frequency.to_string(),
                    value: value * self.question.periods as f64,
                    parameter,
                    at,
                });
            }
        }
        Ok(self)
    }

    /// The evaluations that the simulations of one purpose may take together.
    pub(super) fn budget(&self) -> SimulationBudget {
        SimulationBudget { evaluations: MOST_EVALUATIONS, interrupt: self.question.interrupt }
    }

    pub(super) fn walk(&self, ordinary: f64, size: f64) -> ContinuationSettings {
        ContinuationSettings {
            // Motions with corners and slow motions have long series of harmonics, and other
            // criteria for their ends.
            resolved: self.question.harmonics.is_none()
                && self.driven.smooth
                && !self.driven.self_excited,
            ordinary,
            range: self.question.range,
            longest: LONGEST_STEP,
            most: MOST_POINTS,
            size,
            interrupt: self.question.interrupt,
        }
    }

    /// The whole diagram with this many harmonics; some of its branches may be known already.
    fn attempt(
        &self,
        harmonics: usize,
        seeds: &[Seed],
        known: &[BranchPath],
    ) -> Result<ResponseDiagram, ResponseError> {
        let question = self.question;
        let balance = DrivenBalance::new(&self.driven, harmonics);
        let mut paths = self.branches_through(&balance, seeds, size_of(seeds), known);
        let largest_motion = paths.iter().map(|path| largest(&balance, path));
        let size = largest_motion.fold(size_of(seeds), f64::max);
        self.follow_sticking(&balance, seeds, &mut paths, size);
        let (all_judged, changes, ripple) = self.judged_paths(&balance, seeds, &mut paths);
        // Sizes are compared with the largest motion of all branches.
        let size = paths.iter().map(|path| largest(&balance, path)).fold(0.0, f64::max);
        let bifurcations = self.bifurcations(&balance, changes, size);
        let branches: Vec<Branch> = paths
            .iter()
            .zip(all_judged)
            .map(|(path, judged)| {
                let points = path.nodes.iter().zip(judged);
                Branch {
                    points: points
                        .map(|(node, judged)| self.point(&balance, node, judged, size))
                        .collect(),
                    ends: path.ends,
                    mirrored: path.mirrored,
                }
            })
            .collect();
        if branches.is_empty() {
            return Err(match question.interrupt.is_requested() || self.driven.undamped {
                true => self.no_motion_error(),
                false => ResponseError::NotFollowed {
                    parameter: question.parameter,
                    range: question.range,
                },
            });
        }
        let simulated = self.simulated(&branches);
        let elsewhere = self.unfollowed(&balance, &paths, seeds, size);
        let points = || branches.iter().flat_map(|branch| &branch.points);
        let complete = !question.interrupt.is_requested();
        let amplitude = points().map(|point| point.amplitude).fold(0.0, f64::max);
        let response = ResponseDiagram {
            question: question.clone(),
            frequency: self.driven.frequency.clone(),
            self_excited: self.driven.self_excited,
            undamped: self.driven.undamped,
            jumps: self.driven.jumps() > 0,
            by_map: !self.driven.is_balanced() || self.period_series.is_some(),
            harmonics: balance.core.harmonics,
            backbone: backbones(
                &self.oscillator,
                &self.driven,
                (harmonics, self.period_series.is_some()),
                question.range,
                1.15 * amplitude,
            )?,
            branches,
            bifurcations,
            ripple,
            simulated,
            elsewhere,
            verdict: Verdict::Fail,
            error: None,
            unjudged: 0,
            slow: None,
            equilibria: vec![],
            curves: vec![],
            stable_motions: None,
            counters: vec![],
            modes: vec![],
            exhausted: false,
            sparse: vec![],
            complete,
        };
        Ok(response.with_verdict())
    }

    /// This response without the ends of branches at which no true motion was found, because the
    /// period grows without bound or there are too few harmonics.
    fn without_tails(
        &self,
        mut response: ResponseDiagram,
    ) -> Result<ResponseDiagram, ResponseError> {
        /// Largest number of consecutive points without a true motion that counts as accidental.
        const FEW: usize = 3;
        let tolerance = response.question.tolerance;
        let mut slowest: Vec<f64> = Vec::new();
        for branch in &mut response.branches {
            let points = &mut branch.points;
            let count = points.len();
            let judged = (0..count).filter(|index| points[*index].error.is_some());
            let judged: Vec<usize> = judged.collect();
            let together = judged.chunk_by(|one, next| next - one <= FEW + 1);
            let longest = together.max_by_key(|part| part.len()).unwrap_or_default();
            let (Some(&(mut first)), Some(&(mut last))) = (longest.first(), longest.last()) else {
                points.clear();
                slowest.push(f64::INFINITY);
                continue;
            };
            // The error grows before the true motion is lost, so that the end is put where it was
            // within tolerance.
            let within =
                |index: &&usize| points[**index].error.is_some_and(|error| error <= tolerance);
            if count - 1 - last > FEW {
                last = longest.iter().rfind(within).copied().unwrap_or(last);
            }
            if first > FEW {
                first = longest.iter().find(within).copied().unwrap_or(first);
            }
            if count - 1 - last > FEW {
                points.truncate(last + 1);
                branch.ends[1] = BranchEnd::Slow;
            }
            if first > FEW {
                points.drain(..first);
                branch.ends[0] = BranchEnd::Slow;
            }
            let frequencies = points.iter().map(|point| point.frequency);
            slowest.push(frequencies.fold(f64::INFINITY, f64::min));
        }
        // Bifurcations beyond the new end of a branch are not reliable.
        let slowest_of = |branch: usize| slowest.get(branch).copied().unwrap_or(f64::INFINITY);
        let bifurcations = response.bifurcations.iter();
        let kept = bifurcations.filter(|found| found.frequency >= slowest_of(found.branch));
        let number =
            |branch: usize| (0..branch).filter(|index| slowest_of(*index).is_finite()).count();
        response.bifurcations =
            kept.map(|found| Bifurcation { branch: number(found.branch), ..*found }).collect();
        response.branches.retain(|branch| !branch.points.is_empty());
        match response.branches.is_empty() {
            true => Err(self.no_motion_error()),
            false => Ok(response.with_verdict()),
        }
    }

    /// Verifies every point of the branches and locates the bifurcations between them; branches
    /// that cross are followed and added.
    pub(super) fn judged_paths(
        &self,
        balance: &DrivenBalance,
        seeds: &[Seed],
        paths: &mut Vec<BranchPath>,
    ) -> (Vec<Vec<PointJudgement>>, Vec<Change>, Option<Ripple>) {
        let size = paths.iter().map(|path| largest(balance, path));
        let ordinary = size_of(seeds);
        let walk = self.walk(ordinary, size.fold(ordinary, f64::max));
        // Multipliers have a meaning only for a true motion.
        let of_true_motion = |judged: PointJudgement| judged.1.map(|truth| truth.floquet);
        let floquet = |node: &BranchNode| match node.truth {
            Some(truth) => Some(truth.floquet),
            None => of_true_motion(self.judged(balance, node)),
        };
        let mut all_judged: Vec<Vec<PointJudgement>> = Vec::new();
        let mut changes = Vec::new();
        let mut ripple = None;
        while let Some(path) = paths.get(all_judged.len()).cloned() {
            let branch = all_judged.len();
            let points: usize = paths.iter().map(|path| path.nodes.len()).sum();
            let before: usize = all_judged.iter().map(Vec::len).sum();
            self.question.progress.begin(points - before);
            let judged = self.judged_in_time(balance, &path.nodes);
            let between_two =
                |from: &BranchNode, to: &BranchNode, part: f64| match from.truth.or(to.truth) {
                    Some(_) if self.period_series.is_some() => {
                        self.shot_between(balance, from, to, part)
                    }
                    Some(_) => self.stuck_between(balance, from, to, part),
                    None => walk.between(balance, from, to, part),
                };
            let points = path.nodes.into_iter().zip(judged).collect();
            let points = self.add_narrow(balance, points, &between_two);
            let (nodes, judged): (Vec<BranchNode>, Vec<PointJudgement>) =
                points.into_iter().unzip();
            paths[branch].nodes.clone_from(&nodes);
            let mut own: Vec<LocatedBifurcation> = Vec::new();
            for (index, (pair, known)) in nodes.windows(2).zip(judged.windows(2)).enumerate() {
                let ([from, to], [before, after]) = (pair, known) else {
                    continue;
                };
                if self.question.interrupt.is_requested() {
                    break;
                }
                let between = |part: f64| between_two(from, to, part);
                let known = [(from, of_true_motion(*before)), (to, of_true_motion(*after))];
                let found = bifurcation::between(balance, known, &between, &floquet);
                for (mut kind, node) in found {
                    let crossed =
                        kind == BifurcationKind::BranchPoint && paths.len() < MOST_BRANCHES;
                    if crossed && self.follow_crossing(balance, &walk, &node, paths) {
                        kind = BifurcationKind::Centre;
                    }
                    own.push((index, kind, node));
                }
            }
            let (own, left_out) = ripple::without_ripple(own, &nodes, &judged);
            ripple = Ripple::merged_with(ripple, &left_out);
            changes.extend(own.into_iter().map(|(_, kind, node)| (kind, branch, node)));
            let ends = path.ends.iter().zip([nodes.first(), nodes.last()]);
            let born = ends.filter(|(end, _)| **end == BranchEnd::Rest);
            changes.extend(
                born.filter_map(|(_, node)| Some((BifurcationKind::Hopf, branch, node?.clone()))),
            );
            all_judged.push(judged);
        }
        (all_judged, changes, ripple)
    }

    /// The bifurcations of the branches, each once.
    fn bifurcations(
        &self,
        balance: &DrivenBalance,
        changes: Vec<Change>,
        size: f64,
    ) -> Vec<Bifurcation> {
        let mut found: Vec<Bifurcation> = Vec::new();
        for (kind, branch, node) in changes {
            let point = self.point(balance, &node, (None, None), size);
            let new = Bifurcation {
                kind,
                branch,
                parameter: point.parameter,
                frequency: point.frequency,
                amplitude: point.amplitude,
                peak: point.peak,
                criticality: None,
            };
            if !found.iter().any(|known| new.is_near(known, self.question.range, size)) {
                found.push(new);
            }
        }
        found
    }

    /// Updates the progress of the search for initial motions.
    pub(super) fn count(&self, [values, starts]: [usize; 2], motions: usize) {
        let before = self.tried.get();
        self.tried.set(SeedSearch {
            values: before.values + values,
            starts: before.starts + starts,
            motions,
        });
    }

    /// The error of a search without a motion.
    pub(super) fn no_motion_error(&self) -> ResponseError {
        let ResponseRequest { parameter, range, .. } = *self.question;
        match (self.question.interrupt.is_requested(), self.driven.self_excited) {
            (true, _) => ResponseError::Interrupted { parameter, tried: self.tried.get() },
            (false, true) => ResponseError::NoCycle { parameter, range },
            (false, false) => ResponseError::NoMotion {
                parameter,
                at: range[0],
                undamped: self.driven.undamped,
                repeats: None,
            },
        }
    }
}

/// A bifurcation of a branch, which is counted from 0.
type Change = (BifurcationKind, usize, BranchNode);

//! Whether the motions that come off at a bifurcation are stable beside it.
//!
//! ```text
//! branch point        motions on one side alone: a pitchfork
//! period doubling     P(P(y; p); p) = y  near the orbit, in the direction of the multiplier -1
//! Neimark-Sacker      w -> e^(i theta) w (1 + d w w^*):  the sign of Re d
//! ```
//!
//! At the first two, motions of the new kind are followed a little way from the bifurcation. Where they
//! stand on the side on which the old motion is unstable, they have taken over the stability: the
//! bifurcation is supercritical. At the last, no motion repeats itself: the cubic normal form of the
//! map decides ([`normal_form`](crate::numeric::normal_form)). The map of a cycle is that from a plane
//! across it to the same plane, one turn later.

use nalgebra::{DMatrix, DVector};

use super::branches::Start;
use super::changes::change_between;
use super::equilibria::null_vector;
use super::problem::{Anchor, CoupledProblem, Kind, Orbit, Orbits, Travel};
use crate::numeric::normal_form::{CubicTerm, cubic_term};
use crate::numeric::orbit_branch::{OrbitEquations, PeriodImage};
use crate::response::bifurcation::BifurcationKind;
use crate::response::{Bifurcation, Branch, Criticality, ResponseDiagram, SteadyMotion};

/// Distances of the new motion from the bifurcation, in the sizes of the states.
const APART: [f64; 2] = [0.01, 0.02];

impl CoupledProblem<'_> {
    /// The travel of the largest motions of a single coordinate.
    pub(super) fn scale_of(&self, response: &ResponseDiagram) -> Travel {
        let points = || response.branches.iter().flat_map(|branch| &branch.points);
        let largest = |sizes: &mut dyn Iterator<Item = f64>| sizes.fold(0.0, f64::max);
        let place = largest(&mut points().map(|point| point.peak));
        let rate = largest(&mut points().map(|point| point.peak * point.frequency));
        vec![place, rate]
    }

    /// The criticality of a bifurcation of a single driven coordinate, on any of the branches that pass
    /// it; `None` where it is not known.
    pub(super) fn criticality_among(
        &self,
        branches: &[Branch],
        change: &Bifurcation,
        scale: &[f64],
    ) -> Option<Criticality> {
        use BifurcationKind::{BranchPoint, NeimarkSacker, PeriodDoubling};
        /// Difference of the peaks, in that of the largest motion, within which a branch passes.
        const NEAR: f64 = 1e-2;
        let has_map = matches!(change.kind, BranchPoint | PeriodDoubling | NeimarkSacker);
        if !has_map || !matches!(self.kind, Kind::Driven(_)) {
            return None;
        }
        let apart = |pair: &[SteadyMotion]| {
            let [from, to] = [pair[0].parameter, pair[1].parameter];
            let part = (change.parameter - from) / (to - from);
            let peak = pair[0].peak + part * (pair[1].peak - pair[0].peak);
            let apart = (peak - change.peak).abs();
            ((0.0..=1.0).contains(&part) && apart <= NEAR * scale[0]).then_some(apart)
        };
        let pairs = branches.iter().flat_map(|branch| branch.points.windows(2));
        let mut pairs: Vec<_> = pairs.filter_map(|pair| Some((apart(pair)?, pair))).collect();
        pairs.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        pairs.into_iter().find_map(|(_, pair)| self.criticality_between(pair, change.kind, scale))
    }

    /// The criticality of a bifurcation of this kind between two neighbouring motions of a single driven
    /// coordinate.
    fn criticality_between(
        &self,
        pair: &[SteadyMotion],
        kind: BifurcationKind,
        scale: &[f64],
    ) -> Option<Criticality> {
        // Both tangents lead along the branch.
        let forward = pair[0].parameter < pair[1].parameter;
        let orbit = |point: &SteadyMotion| {
            let start =
                Start { parameter: point.parameter, unknowns: point.start.to_vec(), section: 0.0 };
            let orbit = self.orbit_near(&start, scale, Anchor::NONE)?;
            Some(if forward { orbit } else { orbit.reversed() })
        };
        let (from, to) = (orbit(&pair[0])?, orbit(&pair[1])?);
        self.with_orbits(scale, Anchor::NONE, |orbits| {
            let at = change_between(self, orbits, kind, [&from, &to])?;
            self.criticality(kind, &at, [&from, &to], orbits, scale)
        })
    }

    /// The criticality of a bifurcation between two orbits of a branch; `None` where it is not known.
    pub(super) fn criticality(
        &self,
        kind: BifurcationKind,
        at: &Orbit,
        [from, to]: [&Orbit; 2],
        orbits: &Orbits,
        scale: &[f64],
    ) -> Option<Criticality> {
        let stable = |orbit: &Orbit| Some(self.is_stable(&self.multipliers(orbit)?));
        let [before, after] = [stable(from)?, stable(to)?];
        if before == after {
            return None;
        }
        if kind == BifurcationKind::NeimarkSacker {
            return self.torus(at, scale);
        }
        let here = at.parameter();
        if (from.parameter() - here) * (to.parameter() - here) >= 0.0 {
            return None;
        }
        let unstable = if before { to } else { from };
        let side = match kind {
            BifurcationKind::BranchPoint => {
                let beside = orbits.beside_crossing(at);
                let sides: Vec<f64> =
                    beside.iter().map(|orbit| (orbit.parameter() - here).signum()).collect();
                match sides.as_slice() {
                    [one, other] if one == other => *one,
                    _ => return None,
                }
            }
            // The parameter goes with the square of the distance from the bifurcation.
            BifurcationKind::PeriodDoubling => {
                let [near, far] = APART.map(|apart| self.doubled(at, orbits, scale, apart));
                let [near, far] = [near?.parameter(), far?.parameter()];
                // Across a corner the motion at the larger distance may be one of another law.
                let has_corners = !self.smooth || self.in_time.jumps();
                if has_corners && (near - here) * (far - near) < 0.0 {
                    return None;
                }
                (far - near).signum()
            }
            _ => return None,
        };
        Some(match side == (unstable.parameter() - here).signum() {
            true => Criticality::Supercritical,
            false => Criticality::Subcritical,
        })
    }

    /// A motion of twice the period near one with the multiplier -1, at a distance from it.
    fn doubled(&self, at: &Orbit, orbits: &Orbits, scale: &[f64], apart: f64) -> Option<Orbit> {
        let n = self.states.len();
        let mut direction = null_vector(at.kept.monodromy.clone() + DMatrix::identity(n, n))?;
        let mut guess = at.unknowns.clone();
        if matches!(self.kind, Kind::SelfExcited) {
            // The condition on the beginning of a cycle holds in the direction as well.
            let slopes = at.monodromy.view((n, 0), (1, n)).transpose();
            let flow = self.in_time.rates_at(&at.unknowns.as_slice()[..n], 0.0, at.parameter());
            let shift = slopes.dot(&direction) / slopes.dot(&flow);
            direction -= flow * shift;
            guess[n] *= 2.0;
        }
        let sizes = self.sizes(&at.kept.travel, scale, &guess);
        let mut along = DVector::zeros(guess.len());
        for i in 0..n {
            along[i] = direction[i] / sizes[i];
        }
        let along = along.normalize();
        let guess = guess + (&along * apart).component_mul(&sizes);
        let twice = |start: &DVector<f64>, parameter: f64| {
            let first = (orbits.map)(start, parameter)?;
            let second = (orbits.map)(&first.end, parameter)?;
            Some(PeriodImage {
                by_start: &second.by_start * &first.by_start,
                by_parameter: &second.by_start * &first.by_parameter + &second.by_parameter,
                ..second
            })
        };
        let sizes_of = |_: &Orbit| sizes.clone();
        match self.kind {
            Kind::Driven(_) => OrbitEquations { map: &twice, sizes: &sizes_of, ..*orbits }
                .orbit_along(&guess, &along, &sizes),
            // The period is an unknown.
            Kind::SelfExcited => orbits.orbit_along(&guess, &along, &sizes),
            Kind::Free => None,
        }
    }

    /// The criticality of a Neimark-Sacker point, by the cubic normal form of the map.
    fn torus(&self, at: &Orbit, scale: &[f64]) -> Option<Criticality> {
        /// Numbers of step sizes that must give the same coefficient: more where the map has corners, which
        /// it is smooth beside as long as the orbit crosses those of the forces.
        const AGREEING: [usize; 2] = [2, 3];
        if self.undamped {
            return None;
        }
        let agreeing = AGREEING[usize::from(!self.smooth || self.in_time.jumps())];
        let n = self.states.len();
        let multipliers = self.multipliers(at)?;
        let pairs = multipliers.into_iter().filter(|value| value.im > 0.0);
        let multiplier = { pairs }
            .min_by(|one, other| (one.norm() - 1.0).abs().total_cmp(&(other.norm() - 1.0).abs()))?;
        let section = Section::new(self, at, scale)?;
        let sizes = &section.sizes;
        let scaled = DMatrix::from_fn(n, n, |i, j| at.kept.monodromy[(i, j)] * sizes[j] / sizes[i]);
        let derivative = section.basis.transpose() * scaled * &section.basis;
        let map = |place: &DVector<f64>| section.image(place);
        Some(match cubic_term(&map, &derivative, multiplier, agreeing)? {
            CubicTerm::StrongResonance => Criticality::StronglyResonant,
            CubicTerm::Coefficient(cubic) if cubic < 0.0 => Criticality::Supercritical,
            CubicTerm::Coefficient(_) => Criticality::Subcritical,
        })
    }
}

/// The states near an orbit of which the map is asked for: all states of a driven motion, those in the
/// plane across a cycle at its beginning. Places are counted from the orbit, in the sizes of the states.
struct Section<'a> {
    problem: &'a CoupledProblem<'a>,
    parameter: f64,
    start: DVector<f64>,
    /// The time at the start.
    begin: f64,
    period: f64,
    sizes: DVector<f64>,
    /// The directions of the section, in columns.
    basis: DMatrix<f64>,
    /// The direction across the section, of a cycle.
    across: Option<DVector<f64>>,
}

impl<'a> Section<'a> {
    fn new(problem: &'a CoupledProblem, at: &Orbit, scale: &[f64]) -> Option<Self> {
        let (n, parameter) = (problem.states.len(), at.parameter());
        let start = at.unknowns.rows(0, n).into_owned();
        let sizes = DVector::from_vec(problem.state_sizes(&at.kept.travel, scale));
        let (basis, across) = match problem.kind {
            Kind::SelfExcited => {
                let flow = problem.in_time.rates_at(start.as_slice(), 0.0, parameter);
                let across = flow.component_div(&sizes).normalize();
                // The directions at right angles to the flow have the eigenvalue 1.
                let onto = DMatrix::identity(n, n) - &across * across.transpose();
                let eigen = onto.symmetric_eigen();
                let inside: Vec<usize> = (0..n).filter(|i| eigen.eigenvalues[*i] > 0.5).collect();
                (eigen.eigenvectors.select_columns(&inside), Some(across))
            }
            Kind::Driven(_) => (DMatrix::identity(n, n), None),
            Kind::Free => return None,
        };
        let period = std::f64::consts::TAU / problem.frequency_of(at);
        let begin = problem.time_of_section(at);
        Some(Self { problem, parameter, start, begin, period, sizes, basis, across })
    }

    /// The place after a period, or after one turn.
    fn image(&self, place: &DVector<f64>) -> Option<DVector<f64>> {
        /// The longest turn, in periods of the orbit.
        const LONGEST: f64 = 1.2;
        const MOST: usize = 20;
        let begin = &self.start + (&self.basis * place).component_mul(&self.sizes);
        let away =
            |end: Vec<f64>| (DVector::from_vec(end) - &self.start).component_div(&self.sizes);
        let duration = self.period * if self.across.is_some() { LONGEST } else { 1.0 };
        let times = [self.begin, duration];
        let path = self.problem.by_series(begin.as_slice(), times, self.parameter)?;
        let mut time = self.period;
        if let Some(across) = &self.across {
            for _ in 0..MOST {
                let state = path.states_at(time)?;
                let flow = self.problem.in_time.rates_at(&state, 0.0, self.parameter);
                let step = across.dot(&away(state)) / across.dot(&flow.component_div(&self.sizes));
                time -= step;
                if step.abs() <= 1e-14 * self.period {
                    break;
                }
            }
        }
        Some(self.basis.transpose() * away(path.states_at(time)?))
    }
}

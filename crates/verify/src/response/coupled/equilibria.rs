//! Branches of equilibria of systems that nothing drives, with their folds, branch points and Hopf
//! points.
//!
//! ```text
//! F(y; p) = 0,   small disturbances as exp(lambda t):  F_y u = lambda u,   Hopf: lambda = i omega
//! ```
//!
//! An equilibrium is a fixed point of y + tau F(y; p), so that its branch is followed as that of an
//! orbit is.

use std::cell::Cell;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

use super::changes::eigenvalues;
use super::problem::{CoupledProblem, SMALLEST};
use super::starts::spread;
use crate::numeric::ode::root::find_root;
use crate::numeric::orbit_branch::{OrbitBranchLimits, OrbitEquations, OrbitPoint, PeriodImage};
use crate::response::bifurcation::{BifurcationKind, bisect_sign_change};
use crate::response::{
    Equilibrium, EquilibriumBranch, EquilibriumChange, LONGEST_STEP, MOST_POINTS,
};

/// A Hopf point: the equilibrium, the frequency, and the direction in which cycles begin.
pub(super) struct HopfPoint {
    pub(super) parameter: f64,
    pub(super) state: Vec<f64>,
    pub(super) frequency: f64,
    pub(super) direction: DVector<f64>,
    /// Whether the equilibrium is the less stable for larger parameters.
    pub(super) unstable_above: bool,
    /// The branch of equilibria and the change on it that this is.
    pub(super) place: [usize; 2],
}

type Rest = OrbitPoint<()>;

/// Values of the parameter at which equilibria are searched for, and starts at each.
const SEARCH: [usize; 2] = [5, 12];

/// Largest number of branches.
const MOST: usize = 16;

/// The part of the largest value below which one is zero but for rounding.
const ROUNDING: f64 = 1e-12;

impl CoupledProblem<'_> {
    /// The eigenvalues of the linear equations at a state.
    pub(super) fn growth(&self, state: &[f64], parameter: f64) -> Option<Vec<Complex<f64>>> {
        eigenvalues(self.in_time.linearised(state, 0.0, parameter).by_state)
    }

    /// The branches of equilibria in the range, and their Hopf points.
    pub(super) fn equilibria(&self) -> (Vec<EquilibriumBranch>, Vec<HopfPoint>) {
        let n = self.states.len();
        let [low, high] = self.question.range;
        let map = |state: &DVector<f64>, parameter: f64| {
            let found = self.in_time.linearised(state.as_slice(), 0.0, parameter);
            let finite =
                found.rates.iter().chain(found.by_state.iter()).all(|value| value.is_finite());
            finite.then(|| PeriodImage {
                end: state + &found.rates,
                by_start: DMatrix::identity(n, n) + &found.by_state,
                by_parameter: found.by_parameter,
                path: (),
            })
        };
        let ordinary = Cell::new(1e-3);
        let sizes_at = |state: &[f64]| {
            // Velocities are zero: their size is that of the places.
            let largest = state.iter().map(|value| value.abs()).fold(ordinary.get(), f64::max);
            let size = |value: &f64| value.abs().max(SMALLEST * largest);
            DVector::from_iterator(n + 1, state.iter().map(size).chain([high - low]))
        };
        let sizes = |rest: &Rest| sizes_at(rest.start());
        let equations = OrbitEquations {
            map: &map,
            smooth: true,
            accuracy: 4e-15,
            rounding: 1e-9,
            keep: &|_, _| (),
            sizes: &sizes,
        };
        let limits = OrbitBranchLimits {
            range: self.question.range,
            longest: LONGEST_STEP,
            most: MOST_POINTS,
            interrupt: self.question.interrupt,
        };
        let mut branches: Vec<Vec<Rest>> = Vec::new();
        let is_known = |rest: &Rest, branches: &[Vec<Rest>]| {
            let sizes = sizes(rest);
            branches.iter().flat_map(|branch| branch.windows(2)).any(|pair| {
                let [from, to] = pair else { return false };
                let way = to.parameter() - from.parameter();
                let part =
                    if way == 0.0 { 0.0 } else { (rest.parameter() - from.parameter()) / way };
                let guess = &from.unknowns + (&to.unknowns - &from.unknowns) * part;
                let near = (&guess - &rest.unknowns).component_div(&sizes).norm() < 0.2;
                let inside = (-1e-9..=1.0 + 1e-9).contains(&part);
                let state = guess.rows(0, n).into_owned();
                inside
                    && near
                    && equations.orbit_at(&state, rest.parameter(), &sizes).is_some_and(|found| {
                        (&found.unknowns - &rest.unknowns).component_div(&sizes).norm() < 1e-6
                    })
            })
        };
        let add = |rest: Rest, branches: &mut Vec<Vec<Rest>>| {
            if branches.len() >= MOST || is_known(&rest, branches) {
                return;
            }
            let branch = equations.branch_through(rest, &limits, &|_| false).0;
            // Beside a crossing near an end of the range it may begin beyond that end.
            if !is_known(&branch[branch.len() / 2], branches) {
                branches.push(branch);
            }
        };
        let [values, starts] = SEARCH;
        let mut found = Vec::new();
        for value in 0..values {
            let parameter = low + (high - low) * (value as f64 + 0.5) / values as f64;
            for index in 0..starts {
                let size = if index == 0 { 0.0 } else { 10.0_f64.powi(index as i32 % 4 - 2) * 3.0 };
                let state = |k: usize| match k < self.coordinates {
                    true => size * (2.0 * spread(value * starts + index, k) - 1.0),
                    false => 0.0,
                };
                let guess = DVector::from_iterator(n, (0..n).map(state));
                let sizes = DVector::from_element(n + 1, 1.0);
                let rest = equations.orbit_at(&guess, parameter, &sizes);
                // Where dry friction holds a place there is rest all around it, and no linear equations.
                found.extend(rest.filter(|rest| !self.in_time.is_on_jump(rest.start(), parameter)));
            }
        }
        let largest = found.iter().flat_map(|rest| rest.start()).map(|value| value.abs());
        ordinary.set(largest.fold(ordinary.get(), f64::max));
        for rest in found {
            add(rest, &mut branches);
        }
        let mut index = 0;
        while index < branches.len() {
            for pair in branches[index].clone().windows(2) {
                let [from, to] = pair else { continue };
                if from.orientation == to.orientation {
                    continue;
                }
                let at = crossing(&equations, from, to);
                for beside in at.map(|at| equations.beside_crossing(&at)).unwrap_or_default() {
                    add(beside, &mut branches);
                }
            }
            index += 1;
        }
        let determinant = |rest: &Rest| {
            let at = self.in_time.linearised(rest.start(), 0.0, rest.parameter());
            at.by_state.determinant()
        };
        let mut hopf = Vec::new();
        // A branch that begins at a crossing turns back there without a fold of its own.
        let mut crossings: Vec<Rest> = Vec::new();
        for pair in branches.iter().flat_map(|branch| branch.windows(2)) {
            if let [from, to] = pair
                && from.orientation != to.orientation
                && from.parameter_slope() * to.parameter_slope() > 0.0
            {
                crossings.extend(located_crossing(&equations, determinant, from, to));
            }
        }
        let is_crossing = |rest: &Rest| {
            crossings.iter().any(|other| {
                (&other.unknowns - &rest.unknowns).component_div(&sizes(rest)).norm() < 1e-3
            })
        };
        let located = |rest: &Rest| {
            let parameter = rest.parameter();
            if parameter.abs() < ROUNDING * (high - low) { 0.0 } else { parameter }
        };
        let value = |rest: &Rest| {
            let value = self.shown.call(&rest.start()[..self.coordinates]);
            if value.abs() < ROUNDING * ordinary.get() { 0.0 } else { value }
        };
        let described = branches.iter().enumerate().map(|(index, branch)| {
            let mut changes = Vec::new();
            for pair in branch.windows(2) {
                let [from, to] = pair else { continue };
                let mut push = |kind, at: &Rest| {
                    changes.push(EquilibriumChange {
                        kind,
                        parameter: located(at),
                        value: value(at),
                        criticality: None,
                    });
                };
                if from.parameter_slope() * to.parameter_slope() < 0.0 {
                    let slope = |part: f64| {
                        equations
                            .between(from, to, part)
                            .map_or(f64::NAN, |at| at.parameter_slope())
                    };
                    let part = find_root(slope, 0.0, 1.0).ok();
                    let at = part.and_then(|part| equations.between(from, to, part));
                    if let Some(at) = at.filter(|at| !is_crossing(at)) {
                        push(BifurcationKind::Fold, &at);
                    }
                } else if from.orientation != to.orientation
                    && let Some(at) = located_crossing(&equations, determinant, from, to)
                {
                    push(BifurcationKind::BranchPoint, &at);
                }
                if let Some((at, point)) = self.hopf_between(&equations, from, to) {
                    push(BifurcationKind::Hopf, &at);
                    hopf.push(HopfPoint { place: [index, changes.len() - 1], ..point });
                }
            }
            let point = |rest: &Rest| {
                let at = self.in_time.linearised(rest.start(), 0.0, rest.parameter());
                let step = at.by_state.lu().solve(&at.rates);
                let growth = self.growth(rest.start(), rest.parameter());
                let growth =
                    growth.map(|all| all.iter().map(|value| value.re).fold(f64::MIN, f64::max));
                Equilibrium {
                    parameter: rest.parameter(),
                    value: value(rest),
                    state: rest.start().to_vec(),
                    error: step
                        .map(|step| step.amax() / ordinary.get())
                        .filter(|error| error.is_finite()),
                    growth,
                    stable: growth.map(|growth| match self.undamped {
                        true => growth <= 1e-7,
                        false => growth < 0.0,
                    }),
                }
            };
            EquilibriumBranch { points: branch.iter().map(point).collect(), changes }
        });
        (described.collect(), hopf)
    }

    /// The Hopf point between two equilibria, where the growth of a complex pair changes its sign.
    fn hopf_between(
        &self,
        equations: &OrbitEquations<(), ()>,
        from: &Rest,
        to: &Rest,
    ) -> Option<(Rest, HopfPoint)> {
        let complex = |rest: &Rest| -> Option<Vec<Complex<f64>>> {
            let all = self.growth(rest.start(), rest.parameter())?;
            Some(all.into_iter().filter(|value| value.im > 1e-9 * value.norm()).collect())
        };
        let unstable = |all: &[Complex<f64>]| all.iter().filter(|value| value.re > 0.0).count();
        let [before, after] = [complex(from)?, complex(to)?];
        if before.len() != after.len() || unstable(&before) == unstable(&after) {
            return None;
        }
        let nearest = |rest: &Rest| -> Option<Complex<f64>> {
            let all = complex(rest)?;
            all.into_iter().min_by(|one, other| one.re.abs().total_cmp(&other.re.abs()))
        };
        let growth = |part: f64| {
            equations
                .between(from, to, part)
                .and_then(|rest| nearest(&rest))
                .map_or(f64::NAN, |z| z.re)
        };
        let at = equations.between(from, to, find_root(growth, 0.0, 1.0).ok()?)?;
        let frequency = nearest(&at)?.im;
        // The real part of the eigenvector, of the null space of J^2 + omega^2.
        let jacobian = self.in_time.linearised(at.start(), 0.0, at.parameter()).by_state;
        let n = jacobian.nrows();
        let square = &jacobian * &jacobian + DMatrix::identity(n, n) * (frequency * frequency);
        let direction = null_vector(square)?;
        let state = at.start().to_vec();
        let unstable_above =
            (unstable(&after) > unstable(&before)) == (to.parameter() > from.parameter());
        let point = HopfPoint {
            parameter: at.parameter(),
            state,
            frequency,
            direction,
            unstable_above,
            place: [0, 0],
        };
        Some((at, point))
    }
}

/// The vector of length one that a matrix shortens most.
pub(super) fn null_vector(matrix: DMatrix<f64>) -> Option<DVector<f64>> {
    if !matrix.iter().all(|value| value.is_finite()) {
        return None;
    }
    let eigen = (matrix.transpose() * matrix).symmetric_eigen();
    Some(eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned())
}

/// The part of the way between two equilibria at which another branch crosses.
fn part_of_crossing(equations: &OrbitEquations<(), ()>, from: &Rest, to: &Rest) -> f64 {
    let orientation = |part: f64| match part {
        0.0 => from.orientation,
        1.0 => to.orientation,
        part => equations.between(from, to, part).map_or(f64::NAN, |rest| rest.orientation),
    };
    bisect_sign_change(orientation)
}

/// An equilibrium near the crossing of branches between two equilibria.
fn crossing(equations: &OrbitEquations<(), ()>, from: &Rest, to: &Rest) -> Option<Rest> {
    let middle = part_of_crossing(equations, from, to);
    [0.0, 1e-6, -1e-6, 1e-3, -1e-3]
        .into_iter()
        .find_map(|aside| equations.between(from, to, (middle + aside).clamp(0.0, 1.0)))
}

/// The crossing of branches between two equilibria by the cubics through the equilibria at four places about it:
/// at the crossing itself, where a determinant vanishes, Newton's method does not tell one branch from the other.
fn located_crossing(
    equations: &OrbitEquations<(), ()>,
    determinant: impl Fn(&Rest) -> f64,
    from: &Rest,
    to: &Rest,
) -> Option<Rest> {
    /// The distances of the four places.
    const ASIDE: [f64; 4] = [-0.02, -0.01, 0.01, 0.02];
    let near = crossing(equations, from, to)?;
    let middle = part_of_crossing(equations, from, to).clamp(0.02, 0.98);
    let rests: Option<Vec<Rest>> =
        ASIDE.iter().map(|aside| equations.between(from, to, middle + aside)).collect();
    let Some(rests) = rests else { return Some(near) };
    let weight = |index: usize, aside: f64| -> f64 {
        let others = ASIDE.iter().enumerate().filter(|(other, _)| *other != index);
        others.map(|(_, other)| (aside - other) / (ASIDE[index] - other)).product()
    };
    let determinants: Vec<f64> = rests.iter().map(determinant).collect();
    let value = |aside: f64| -> f64 {
        determinants.iter().enumerate().map(|(index, own)| weight(index, aside) * own).sum()
    };
    let Ok(root) = find_root(value, ASIDE[0], ASIDE[3]) else { return Some(near) };
    let terms = rests.iter().enumerate().map(|(index, rest)| &rest.unknowns * weight(index, root));
    let unknowns = terms.sum();
    Some(Rest { unknowns, ..near })
}

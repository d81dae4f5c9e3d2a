//! Curves of bifurcations of driven motions in two parameters, and the number of stable motions over
//! both.
//!
//! ```text
//! P(y; p, q) = y,   s(M) = 0        unknowns y, p; q
//! fold               s = det(M - 1)
//! period doubling    s = det(M + 1)
//! grazing            g = dg/dt = 0 at some phase (grazing.rs)
//! Neimark-Sacker     s = det(M o M - 1),    o: the bialternate product, with the products of two multipliers
//! ```
//!
//! (Y. A. Kuznetsov, *Elements of Applied Bifurcation Theory*, Springer 2004, section 10.3.) The curve
//! is a branch of orbits of the map `(y, p) -> (P(y; p, q), p + s)`. Beside a fold or a period doubling
//! the matrix A = M -+ 1 has one singular value that is nearly zero, with the vectors l and r, and
//!
//! ```text
//! d det(A) = det(U) det(V) (product of the other singular values) l^T dM r,     dM r = d/de (P_y, P_p, P_q)(y + e r)
//! ```
//!
//! is a difference of two periods for all unknowns at once. The determinant of a Neimark-Sacker point is
//! differentiated by each unknown in turn, with some 4 (n + 2) periods a point.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::branches::Known;
use super::changes::changes_between;
use super::flow::{Flow, TOLERANCE};
use super::problem::{CoupledProblem, Kind};
use super::state_jumps::{StateJumps, drive_of, flow_in_phase};
use crate::coupled::CoupledEquations;
use crate::expr::Expr;
use crate::numeric::orbit_branch::{OrbitBranchLimits, OrbitEquations, OrbitPoint, PeriodImage};
use crate::parallel::par_map;
use crate::response::bifurcation::BifurcationKind;
use crate::response::continuation::BranchEnd;
use crate::response::{
    BifurcationCurve, BifurcationCurvePoint, LONGEST_STEP, ResponseError, ResponseRequest,
    StableMotions,
};
use crate::symbol::Symbol;

/// Numbers of values of the first and of the second parameter at which stable motions are counted.
const COUNTED: [usize; 2] = [41, 15];

/// Step of differences, in the sizes of the states and in the ranges.
const STEP: f64 = 1e-5;

/// Largest number of points of a curve in one direction.
const MOST: usize = 200;

/// The map of a period with a second parameter, as one more state that does not change.
pub(super) struct TwoParameters<'a> {
    pub(super) problem: &'a CoupledProblem<'a>,
    pub(super) flow: Flow,
    pub(super) scale: &'a [f64],
}

/// A place in the plane of both parameters from which a curve is followed: the state of the motion there at
/// a phase, and both parameters.
pub(super) struct CurveStart<'a> {
    pub(super) state: &'a [f64],
    pub(super) section: f64,
    pub(super) parameters: [f64; 2],
}

/// The images and derivatives at a state with both parameters.
pub(super) struct Image {
    pub(super) end: DVector<f64>,
    pub(super) monodromy: DMatrix<f64>,
    pub(super) by_parameter: DVector<f64>,
    pub(super) by_second: DVector<f64>,
    pub(super) travel: Vec<f64>,
}

impl TwoParameters<'_> {
    /// The image after a period of a state at a phase.
    pub(super) fn image(
        &self,
        start: &[f64],
        section: f64,
        [parameter, second]: [f64; 2],
    ) -> Option<Image> {
        let n = self.problem.states.len();
        let mut sizes = self.problem.state_sizes(&self.scale[..n], self.scale);
        sizes.push(second.abs().max(1e-12));
        let begin: Vec<f64> = start.iter().copied().chain([second]).collect();
        let image = self.flow.image(&begin, [section, section + TAU], parameter, &sizes)?;
        Some(Image {
            end: image.end.rows(0, n).into_owned(),
            monodromy: image.by_start.view((0, 0), (n, n)).into_owned(),
            by_parameter: image.by_parameter.rows(0, n).into_owned(),
            by_second: image.by_start.view((0, n), (n, 1)).column(0).into_owned(),
            travel: image.travel[..n].to_vec(),
        })
    }
}

/// The test function of a bifurcation, which is smooth and zero on its curve.
fn test(kind: BifurcationKind, monodromy: &DMatrix<f64>) -> f64 {
    let n = monodromy.nrows();
    let unit = DMatrix::<f64>::identity(n, n);
    match kind {
        BifurcationKind::PeriodDoubling => (monodromy + unit).determinant(),
        BifurcationKind::NeimarkSacker => {
            let pairs: Vec<(usize, usize)> =
                (1..n).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
            let entry = |row: usize, column: usize| {
                let ((i, j), (k, l)) = (pairs[row], pairs[column]);
                let m = |a: usize, b: usize| monodromy[(a, b)];
                let product = m(i, k) * m(j, l) - m(i, l) * m(j, k);
                if row == column { product - 1.0 } else { product }
            };
            DMatrix::from_fn(pairs.len(), pairs.len(), entry).determinant()
        }
        _ => (monodromy - unit).determinant(),
    }
}

impl CoupledProblem<'_> {
    /// The curves of the bifurcations of these branches in the parameter that varies and a second one.
    ///
    /// # Errors
    /// [`ResponseError`] for a drive whose frequency cannot be written.
    pub(super) fn curves(
        &self,
        equations: &CoupledEquations,
        known: &Known,
        (second, range): (Symbol, [f64; 2]),
    ) -> Result<Vec<BifurcationCurve>, ResponseError> {
        let at = self.question.values.get(second).unwrap_or(f64::NAN);
        let n = self.states.len();
        let mut values: BTreeMap<Symbol, Expr> =
            self.question.values.split(&equations.parameters).0;
        values.remove(&second);
        let mut right: Vec<Expr> = equations
            .rates
            .right
            .iter()
            .map(|rate| rate.substitute_all(&values))
            .collect::<Result<_, _>>()?;
        let mut events = StateJumps::new(self.question, equations, &values)?.flow_events;
        let (_, base) = drive_of(&right, &events, &self.states, self.question.periods)?;
        right.push(Expr::zero());
        for event in &mut events {
            event.after.push(Expr::from(second));
        }
        let states: Vec<Symbol> = self.states.iter().copied().chain([second]).collect();
        let names: Vec<Symbol> =
            states.iter().copied().chain([self.question.parameter, Symbol::new("t")]).collect();
        let flow =
            flow_in_phase(&names, &states, (&right, &events), &base, self.question.parameter)?
                .until(self.question.interrupt);
        let two = TwoParameters { problem: self, flow, scale: &known.scale };
        let mut curves: Vec<BifurcationCurve> = Vec::new();
        for branch in &known.branches {
            let found = branch.runs().flat_map(|run| {
                self.with_orbits(&known.scale, branch.anchor.of_orbit(&run[0]), |orbits| {
                    let pairs = run.windows(2);
                    let found = pairs.map(|pair| changes_between(self, orbits, &pair[0], &pair[1]));
                    found.flatten().collect::<Vec<_>>()
                })
            });
            let ends = [branch.orbits.first(), branch.orbits.last()].into_iter().zip(branch.ends);
            let grazings = ends.filter(|(_, end)| *end == BranchEnd::Grazing);
            let grazings = grazings.filter_map(|(orbit, _)| orbit);
            let grazings = grazings.map(|orbit| (BifurcationKind::Grazing, orbit.clone()));
            let found: Vec<_> = found.chain(grazings).collect();
            for (kind, orbit) in found {
                if kind == BifurcationKind::BranchPoint || self.question.interrupt.is_requested() {
                    continue;
                }
                let place = [orbit.parameter(), at];
                if curves.iter().any(|curve| self.is_on(curve, kind, place, range)) {
                    continue;
                }
                let start = CurveStart {
                    state: &orbit.start()[..n],
                    section: orbit.kept.section,
                    parameters: place,
                };
                let points = match kind {
                    BifurcationKind::Grazing => two.grazing_curve(&orbit, at, range),
                    _ => two.curve(kind, &start, range),
                };
                if points.len() > 1 {
                    let peak = |point: &OrbitPoint<Vec<f64>>| self.shown_travel(&point.kept);
                    let points = points
                        .iter()
                        .map(|point| BifurcationCurvePoint {
                            parameter: point.start()[point.start().len() - 1],
                            along: point.parameter(),
                            peak: peak(point),
                        })
                        .collect();
                    curves.push(BifurcationCurve { kind, points });
                }
            }
        }
        Ok(curves)
    }

    /// Whether a curve of this kind passes a place.
    fn is_on(
        &self,
        curve: &BifurcationCurve,
        kind: BifurcationKind,
        place: [f64; 2],
        [low, high]: [f64; 2],
    ) -> bool {
        /// Distance, in parts of the ranges.
        const NEAR: f64 = 2e-3;
        let [first, last] = self.question.range;
        let scaled = |point: &BifurcationCurvePoint| {
            [(point.parameter - place[0]) / (last - first), (point.along - place[1]) / (high - low)]
        };
        curve.kind == kind
            && curve.points.windows(2).any(|pair| {
                let [a, b] = [&pair[0], &pair[1]].map(scaled);
                let way = [b[0] - a[0], b[1] - a[1]];
                let length = way[0].hypot(way[1]);
                let along = -(a[0] * way[0] + a[1] * way[1]) / (length * length);
                let part = if length > 0.0 { along.clamp(0.0, 1.0) } else { 0.0 };
                (a[0] + part * way[0]).hypot(a[1] + part * way[1]) < NEAR
            })
    }

    /// The travel of the listed quantity, bounded by that of the coordinates in it where it is none of
    /// them itself.
    fn shown_travel(&self, travel: &[f64]) -> f64 {
        let n = self.coordinates;
        let zero = vec![0.0; n];
        let at_rest = self.shown.call(&zero);
        let slopes = (0..n).map(|index| {
            let mut unit = zero.clone();
            unit[index] = 1.0;
            self.shown.call(&unit) - at_rest
        });
        slopes.zip(travel).map(|(slope, travel)| (slope * travel).abs()).sum()
    }
}

impl TwoParameters<'_> {
    /// The points of a curve through a bifurcation, in order.
    fn curve(
        &self,
        kind: BifurcationKind,
        start: &CurveStart,
        range: [f64; 2],
    ) -> Vec<OrbitPoint<Vec<f64>>> {
        let section = start.section;
        let n = self.problem.states.len();
        let [low, high] = self.problem.question.range;
        let states = self.problem.state_sizes(&self.scale[..n], self.scale);
        let mut all = states.clone();
        all.extend([high - low, range[1] - range[0]]);
        let gradient = |unknowns: &[f64], image: &Image| match kind {
            BifurcationKind::NeimarkSacker => self.gradient_by_each(kind, section, unknowns, &all),
            _ => self.gradient_of_determinant(kind, section, unknowns, (image, &states)),
        };
        let first: Vec<f64> = start.state.iter().copied().chain(start.parameters).collect();
        let image = self.image(&first[..n], section, start.parameters);
        let Some(slopes) = image.and_then(|image| gradient(&first, &image)) else { return vec![] };
        let steep = slopes.iter().zip(&all).map(|(slope, size)| (slope * size).abs());
        let steep = steep.fold(0.0, f64::max);
        if !(steep > 0.0 && steep.is_finite()) {
            return vec![];
        }
        // In units of the first parameter.
        let unit = (high - low) / steep;
        let map = |start: &DVector<f64>, second: f64| {
            let unknowns: Vec<f64> = start.iter().copied().chain([second]).collect();
            let image = self.image(&unknowns[..n], section, [unknowns[n], second])?;
            let slopes = gradient(&unknowns, &image)?;
            let mut by_start = image.monodromy.clone().resize(n + 1, n + 1, 0.0);
            by_start.view_mut((0, n), (n, 1)).copy_from(&image.by_parameter);
            for column in 0..n {
                by_start[(n, column)] = unit * slopes[column];
            }
            by_start[(n, n)] = 1.0 + unit * slopes[n];
            Some(PeriodImage {
                end: image.end.push(unknowns[n] + unit * test(kind, &image.monodromy)),
                by_start,
                by_parameter: image.by_second.push(unit * slopes[n + 1]),
                path: image.travel,
            })
        };
        let sizes = DVector::from_vec(all.clone());
        let equations = OrbitEquations {
            map: &map,
            smooth: !self.flow.jumps(),
            accuracy: TOLERANCE,
            rounding: 1e-9,
            keep: &|_, image: &PeriodImage<Vec<f64>>| image.path.clone(),
            sizes: &|_| sizes.clone(),
        };
        let (guess, second) = (DVector::from_column_slice(&first[..=n]), first[n + 1]);
        let Some(point) = equations.orbit_at(&guess, second, &sizes) else { return vec![] };
        let limits = OrbitBranchLimits {
            range,
            longest: LONGEST_STEP,
            most: MOST,
            interrupt: self.problem.question.interrupt,
        };
        let outside = |point: &OrbitPoint<Vec<f64>>| {
            let parameter = point.unknowns[n];
            !(low..=high).contains(&parameter)
                || kind == BifurcationKind::NeimarkSacker && !self.has_pair(point)
        };
        equations.branch_through(point, &limits, &outside).0
    }

    /// The gradient of a test function by all unknowns, by central differences.
    fn gradient_by_each(
        &self,
        kind: BifurcationKind,
        section: f64,
        unknowns: &[f64],
        sizes: &[f64],
    ) -> Option<Vec<f64>> {
        let n = self.problem.states.len();
        let slope = |index: usize| {
            let moved = |sign: f64| {
                let mut moved = unknowns.to_vec();
                moved[index] += sign * STEP * sizes[index];
                let image = self.image(&moved[..n], section, [moved[n], moved[n + 1]])?;
                Some(test(kind, &image.monodromy))
            };
            Some((moved(1.0)? - moved(-1.0)?) / (2.0 * STEP * sizes[index]))
        };
        (0..n + 2).map(slope).collect()
    }

    /// The gradient by all unknowns of det(M - 1), or of det(M + 1) for a period doubling, beside its zero:
    /// up to parts that vanish there (the head of this file).
    fn gradient_of_determinant(
        &self,
        kind: BifurcationKind,
        section: f64,
        unknowns: &[f64],
        (image, sizes): (&Image, &[f64]),
    ) -> Option<Vec<f64>> {
        let n = self.problem.states.len();
        let sign = if kind == BifurcationKind::PeriodDoubling { 1.0 } else { -1.0 };
        let scaled = |i: usize, j: usize| {
            image.monodromy[(i, j)] * sizes[j] / sizes[i] + if i == j { sign } else { 0.0 }
        };
        let decomposed = DMatrix::from_fn(n, n, scaled).try_svd(true, true, f64::EPSILON, 1_000)?;
        let (left, right) = (decomposed.u?, decomposed.v_t?);
        let (least, values) = (decomposed.singular_values.imin(), decomposed.singular_values);
        let others = (0..n).filter(|index| *index != least).map(|index| values[index]);
        let factor = others.product::<f64>() * left.determinant() * right.determinant();
        let beside = |sign: f64| {
            let state: Vec<f64> =
                (0..n).map(|i| unknowns[i] + sign * STEP * sizes[i] * right[(least, i)]).collect();
            self.image(&state, section, [unknowns[n], unknowns[n + 1]])
        };
        let (above, below) = (beside(1.0)?, beside(-1.0)?);
        let along = |column: &dyn Fn(&Image, usize) -> f64| -> f64 {
            let change = |i: usize| (column(&above, i) - column(&below, i)) / (2.0 * STEP);
            factor * (0..n).map(|i| left[(i, least)] / sizes[i] * change(i)).sum::<f64>()
        };
        let by_states = (0..n).map(|j| along(&|image: &Image, i| image.monodromy[(i, j)]));
        let by_parameter = along(&|image: &Image, i| image.by_parameter[i]);
        let by_second = along(&|image: &Image, i| image.by_second[i]);
        Some(by_states.chain([by_parameter, by_second]).collect())
    }

    /// Whether a complex pair of multipliers lies on the unit circle: the test function is zero as
    /// well where the product of two real ones is 1.
    fn has_pair(&self, point: &OrbitPoint<Vec<f64>>) -> bool {
        let n = self.problem.states.len();
        let monodromy = point.monodromy.view((0, 0), (n, n)).into_owned();
        let all = super::changes::eigenvalues(monodromy).unwrap_or_default();
        all.iter().any(|value| value.im > 1e-3 && (value.norm() - 1.0).abs() < 1e-3)
    }
}

/// The numbers of stable motions at values of the parameter that varies and of a second one. The
/// branches at each value of the second are searched for anew, with less effort, on all threads.
///
/// # Errors
/// [`ResponseError`].
pub(super) fn stable_motions(
    question: &ResponseRequest,
    equations: &CoupledEquations,
    (second, range): (Symbol, [f64; 2]),
) -> Result<StableMotions, ResponseError> {
    let spaced = |count: usize, [low, high]: [f64; 2]| -> Vec<f64> {
        (0..count).map(|i| low + (high - low) * i as f64 / (count - 1) as f64).collect()
    };
    let parameters = spaced(COUNTED[0], question.range);
    let along = spaced(COUNTED[1], range);
    question.progress.begin(along.len());
    // A row needs none of the others.
    let row = |value: &f64| -> Option<Result<Vec<usize>, ResponseError>> {
        let found = (!question.interrupt.is_requested()).then(|| {
            let question = question.at(second, *value);
            let problem = CoupledProblem::new(&question, equations)?;
            Ok(problem.stable_at(&problem.driven_branches(true), &parameters))
        });
        question.progress.advance();
        found
    };
    let rows = par_map(&along, row).into_iter();
    let counts: Vec<Vec<usize>> = rows.map_while(|row| row).collect::<Result<_, _>>()?;
    let along = along[..counts.len()].to_vec();
    Ok(StableMotions { parameters, along, counts })
}

impl CoupledProblem<'_> {
    /// The numbers of stable motions of these branches at values of the parameter.
    fn stable_at(&self, known: &Known, parameters: &[f64]) -> Vec<usize> {
        let mut counts = vec![0; parameters.len()];
        for branch in &known.branches {
            let stable: Vec<bool> = branch
                .orbits
                .iter()
                .map(|orbit| self.multipliers(orbit).is_some_and(|all| self.is_stable(&all)))
                .collect();
            for (pair, stable) in branch.orbits.windows(2).zip(stable.windows(2)) {
                let [from, to] = [pair[0].parameter(), pair[1].parameter()];
                if !(stable[0] && stable[1]) {
                    continue;
                }
                // Each point belongs to the way that begins at it.
                let is_passed = |parameter: f64| {
                    let passes = if from < to {
                        (from..to).contains(&parameter)
                    } else {
                        from > parameter && parameter >= to
                    };
                    passes || to == parameter && to == self.question.range[1]
                };
                for (count, _) in
                    counts.iter_mut().zip(parameters).filter(|(_, own)| is_passed(**own))
                {
                    *count += if branch.mirrored { 2 } else { 1 };
                }
            }
        }
        counts
    }
}

/// Whether curves are followed for these equations.
pub(super) fn check(problem: &CoupledProblem) -> Result<(), ResponseError> {
    match problem.kind {
        Kind::Driven(_) if problem.smooth => Ok(()),
        Kind::Driven(_) => Err(ResponseError::CornersAlong),
        Kind::SelfExcited | Kind::Free => Err(ResponseError::NoDriveAlong),
    }
}

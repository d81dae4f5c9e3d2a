//! Multipliers of orbits, and the bifurcations between two orbits of a branch.
//!
//! ```text
//! fold               dp changes its sign along the branch
//! branch point       the determinant of the bordered equations changes its sign, dp does not
//! period doubling    det(M + 1) changes its sign: a multiplier passes -1
//! Neimark-Sacker     a complex pair of multipliers passes the unit circle
//! grazing            the number of impacts in a period changes: the multipliers jump there
//! ```
//!
//! (Y. A. Kuznetsov, *Elements of Applied Bifurcation Theory*, Springer 2004, chapter 10.)

use nalgebra::linalg::Schur;
use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

use super::problem::{CoupledProblem, Kind, Orbit, Orbits};
use crate::numeric::ode::root::find_root;
use crate::response::bifurcation::{BifurcationKind, bisect_sign_change};

/// Distance from the unit circle within which a multiplier of an undamped motion lies on it.
pub(super) const ON_CIRCLE: f64 = 1e-4;

/// Distance from the unit circle below which a multiplier lies on it, by the accuracy of the variations.
const NEUTRAL: f64 = 1e-9;

/// The eigenvalues of a matrix, the largest first; `None` if they could not be found.
pub(super) fn eigenvalues(matrix: DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    const MOST: usize = 1_000;
    if !matrix.iter().all(|value| value.is_finite()) {
        return None;
    }
    // Near a multiple eigenvalue the iteration may not come below the rounding of one number.
    const ROUNDING: [f64; 3] = [f64::EPSILON, 1e-14, 1e-12];
    let schur = ROUNDING.into_iter().find_map(|small| Schur::try_new(matrix.clone(), small, MOST));
    let found = schur?.complex_eigenvalues();
    let mut found: Vec<Complex<f64>> =
        found.iter().map(|value| Complex::new(value.re, value.im)).collect();
    found.sort_by(|one, other| {
        other.norm().total_cmp(&one.norm()).then(other.im.total_cmp(&one.im))
    });
    Some(found)
}

impl CoupledProblem<'_> {
    /// The multipliers of an orbit without those that are 1 for every such motion: one of a cycle,
    /// two of a free motion; and one for each place where dry friction holds it all the time.
    pub(super) fn multipliers(&self, orbit: &Orbit) -> Option<Vec<Complex<f64>>> {
        let mut all = eigenvalues(orbit.kept.monodromy.clone())?;
        let trivial = match self.kind {
            Kind::Driven(_) => 0,
            Kind::SelfExcited => 1,
            Kind::Free => 2,
        };
        for _ in 0..trivial + orbit.kept.encounters.places.len() {
            let from_one = |value: &Complex<f64>| (value - Complex::from(1.0)).norm();
            let nearest = (0..all.len())
                .min_by(|one, other| from_one(&all[*one]).total_cmp(&from_one(&all[*other])))?;
            all.remove(nearest);
        }
        Some(all)
    }

    /// Whether small disturbances of an orbit die out; without damping, whether they do not grow.
    pub(super) fn is_stable(&self, multipliers: &[Complex<f64>]) -> bool {
        let largest = multipliers.iter().map(|value| value.norm()).fold(0.0, f64::max);
        match self.undamped {
            true => largest <= 1.0 + ON_CIRCLE,
            // A coordinate without damping that nothing moves keeps what it has.
            false => largest < 1.0 - NEUTRAL,
        }
    }
}

/// The complex pair of multipliers nearest to the unit circle, as its distance from it.
fn pair_outside(multipliers: &[Complex<f64>]) -> f64 {
    let pairs = multipliers.iter().filter(|value| value.im.abs() > 1e-6 * value.norm());
    let outside = pairs.map(|value| value.norm() - 1.0);
    outside.fold(f64::NAN, |nearest: f64, one| match nearest.abs() < one.abs() {
        true => nearest,
        false => one,
    })
}

/// The test function of a kind of bifurcation, which changes its sign there; NaN if it has no value.
fn test(problem: &CoupledProblem, kind: BifurcationKind, orbit: &Orbit) -> f64 {
    match kind {
        BifurcationKind::Fold => orbit.parameter_slope(),
        BifurcationKind::BranchPoint => orbit.orientation,
        BifurcationKind::PeriodDoubling => {
            let multipliers = problem.multipliers(orbit).unwrap_or_default();
            // The product over all of 1 + mu, each over its own size.
            let factors = multipliers.iter().map(|mu| (mu + 1.0) / (mu.norm() + 1.0));
            factors.product::<Complex<f64>>().re
        }
        BifurcationKind::NeimarkSacker => {
            pair_outside(&problem.multipliers(orbit).unwrap_or_default())
        }
        BifurcationKind::Hopf | BifurcationKind::Centre | BifurcationKind::Grazing => f64::NAN,
    }
}

/// The bifurcations between two neighbouring orbits, each with its orbit.
pub(super) fn changes_between(
    problem: &CoupledProblem,
    orbits: &Orbits,
    from: &Orbit,
    to: &Orbit,
) -> Vec<(BifurcationKind, Orbit)> {
    use BifurcationKind::{BranchPoint, Fold, NeimarkSacker, PeriodDoubling};
    let mut found: Vec<(BifurcationKind, Orbit)> = Vec::new();
    // Across a grazing the multipliers jump, and pass nothing.
    if from.kept.encounters.counts() != to.kept.encounters.counts() {
        let at = grazing_between(orbits, from, to);
        return at.map(|orbit| (BifurcationKind::Grazing, orbit)).into_iter().collect();
    }
    for kind in [BranchPoint, Fold, PeriodDoubling, NeimarkSacker] {
        let Some(orbit) = change_between(problem, orbits, kind, [from, to]) else { continue };
        // A branch that begins at a crossing turns back there without a fold of its own.
        let crossing = found.iter().position(|(other, _)| kind == Fold && *other == BranchPoint);
        match crossing {
            Some(index) => found[index] = (BranchPoint, orbit),
            None => found.push((kind, orbit)),
        }
    }
    found
}

/// The orbits between two neighbouring ones that a search for one of them has found: the next one is
/// looked for near those on both sides of it.
struct Between<'a> {
    orbits: &'a Orbits<'a>,
    ends: [&'a Orbit; 2],
    /// The orbits with their parts of the way, in order.
    found: Vec<(f64, Orbit)>,
}

impl<'a> Between<'a> {
    fn new(orbits: &'a Orbits<'a>, ends: [&'a Orbit; 2]) -> Self {
        Self { orbits, ends, found: vec![(0.0, ends[0].clone()), (1.0, ends[1].clone())] }
    }

    /// Whether an orbit so near to this part of the way is known that both differ by rounding.
    fn is_known(&self, part: f64) -> bool {
        const NEAR: f64 = 1e-10;
        let index = self.found.partition_point(|(other, _)| *other < part);
        let beside = [index.checked_sub(1), Some(index)].into_iter().flatten();
        { beside }
            .filter_map(|index| self.found.get(index))
            .any(|(other, _)| (other - part).abs() < NEAR)
    }

    /// The orbit at a part of the way; `None` if none is found that is no further from the way than this is long.
    fn at(&mut self, part: f64) -> Option<Orbit> {
        let index = self.found.partition_point(|(other, _)| *other < part);
        if let Some((_, orbit)) = self.found.get(index).filter(|(other, _)| *other == part) {
            return Some(orbit.clone());
        }
        let (low, before) = self.found.get(index.checked_sub(1)?)?;
        let (high, behind) = self.found.get(index)?;
        let share = (part - low) / (high - low);
        let [from, to] = self.ends;
        let sizes = (self.orbits.sizes)(from);
        let way = &to.unknowns - &from.unknowns;
        let length = way.component_div(&sizes).norm();
        let place = &from.unknowns + way * part;
        // Where a root acts Newton's method may come to another motion.
        let is_near =
            |orbit: &Orbit| (&orbit.unknowns - &place).component_div(&sizes).norm() <= length;
        let near = on_cubic([before, behind], share, &sizes);
        let orbit = self.orbits.between_from([from, to], part, &near).filter(is_near);
        let orbit = orbit.or_else(|| self.orbits.between(from, to, part).filter(is_near))?;
        self.found.insert(index, (part, orbit.clone()));
        Some(orbit)
    }
}

/// The unknowns at a part of the way between two orbits, on the cubic through both with their tangents, everything in
/// these sizes.
fn on_cubic([from, to]: [&Orbit; 2], part: f64, sizes: &DVector<f64>) -> DVector<f64> {
    let chord = (&to.unknowns - &from.unknowns).component_div(sizes);
    let length = chord.norm();
    let along = |orbit: &Orbit| {
        let tangent = orbit.tangent.component_div(sizes).normalize() * length;
        // A tangent that leads back is none of this way.
        if tangent.dot(&chord) > 0.0 { tangent } else { chord.clone() }
    };
    let rest = 1.0 - part;
    let aside = (along(from) - &chord) * rest - (along(to) - &chord) * part;
    let moved = &chord * part + aside * (part * rest);
    &from.unknowns + moved.component_mul(sizes)
}

/// The orbit between two others at which the number of impacts in a period changes.
fn grazing_between(orbits: &Orbits, from: &Orbit, to: &Orbit) -> Option<Orbit> {
    const HALVINGS: u32 = 40;
    // Newton's method may come to another motion, such as rest, elsewhere.
    let [one, other] = [from.parameter(), to.parameter()];
    let way = (other - one).abs();
    let range = one.min(other) - way..=one.max(other) + way;
    let extent = |orbit: &Orbit| orbit.kept.travel.iter().copied().fold(0.0, f64::max);
    let least = 0.5 * extent(from).min(extent(to));
    let is_between = |orbit: &Orbit| range.contains(&orbit.parameter()) && extent(orbit) >= least;
    let (mut low, mut high) = (0.0, 1.0);
    let mut nearest = from.clone();
    let mut known = Between::new(orbits, [from, to]);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let orbit = known.at(middle);
        match orbit {
            Some(orbit)
                if orbit.kept.encounters.counts() == from.kept.encounters.counts()
                    && is_between(&orbit) =>
            {
                (low, nearest) = (middle, orbit);
            }
            _ => high = middle,
        }
    }
    Some(nearest)
}

/// The orbit of a bifurcation of this kind between two neighbouring orbits.
pub(super) fn change_between(
    problem: &CoupledProblem,
    orbits: &Orbits,
    kind: BifurcationKind,
    [from, to]: [&Orbit; 2],
) -> Option<Orbit> {
    use BifurcationKind::{BranchPoint, NeimarkSacker, PeriodDoubling};
    if matches!(kind, PeriodDoubling | NeimarkSacker) && problem.undamped {
        return None;
    }
    let [before, after] = [from, to].map(|orbit| test(problem, kind, orbit));
    if before.is_nan() || after.is_nan() || before * after >= 0.0 {
        return None;
    }
    // The number of multipliers outside the unit circle.
    let outside = |orbit: &Orbit| {
        let all = problem.multipliers(orbit).unwrap_or_default();
        all.iter().filter(|value| value.norm() > 1.0).count()
    };
    if kind == NeimarkSacker && outside(from).abs_diff(outside(to)) != 2 {
        return None;
    }
    // On the crossing of a cycle with another one a multiplier is 1.
    const AT_ONE: f64 = 0.02;
    let is_cycle = matches!(problem.kind, Kind::SelfExcited);
    let has_one = |orbit: &Orbit| {
        let at_one = |value: &Complex<f64>| (value - Complex::from(1.0)).norm() < AT_ONE;
        problem.multipliers(orbit).is_some_and(|all| all.iter().any(at_one))
    };
    /// Halvings of the way between two orbits after which a crossing would show in the multipliers.
    const HALVINGS: usize = 12;
    let mut known = Between::new(orbits, [from, to]);
    let mut halvings = 0;
    let value = |part: f64| {
        // A search beside a known orbit would go on in rounding.
        if part > 0.0 && part < 1.0 && known.is_known(part) {
            return 0.0;
        }
        let orbit = known.at(part);
        halvings += 1;
        let is_none = |orbit: &Orbit| {
            is_cycle && kind == BranchPoint && halvings > HALVINGS && !has_one(orbit)
        };
        let orbit = orbit.filter(|orbit| !is_none(orbit));
        orbit.map_or(f64::NAN, |orbit| test(problem, kind, &orbit))
    };
    let part = match kind {
        BranchPoint => Some(bisect_sign_change(value)),
        _ => find_root(value, 0.0, 1.0).ok(),
    }?;
    // On a crossing the equations are singular and Newton's method may not converge; an orbit
    // beside it is near enough.
    const BESIDE: [f64; 5] = [0.0, 1e-6, -1e-6, 1e-3, -1e-3];
    let mut orbit = BESIDE.iter().find_map(|aside| known.at((part + aside).clamp(0.0, 1.0)))?;
    if kind == BranchPoint {
        // On the crossing the equations have two independent tangents: that of this branch is
        // along the way from one orbit to the other.
        orbit.tangent = &to.unknowns - &from.unknowns;
        // Where the plane in which a cycle begins touches the cycle, the determinant changes its sign
        // without a crossing.
        if is_cycle && !has_one(&orbit) {
            return None;
        }
    }
    Some(orbit)
}

/// The solution of linear equations; with small singular values left out where they have many.
pub(super) fn least_squares(matrix: DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    const SINGULAR: f64 = 1e-9;
    let found = matrix.try_svd(true, true, f64::EPSILON, 10_000)?;
    let largest = found.singular_values.max();
    found.solve(right, SINGULAR * largest).ok()
}

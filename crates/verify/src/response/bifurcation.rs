//! Bifurcations along a branch: folds, branch points, period doublings and Neimark-Sacker points.
//!
//! ```text
//! fold                     dp changes its sign along the branch; one multiplier is 1
//! branch point             the determinant of the bordered equations changes its sign, dp does not
//! period doubling          det(M + 1) = 1 + tr M + det M changes its sign: a multiplier passes -1
//! Neimark-Sacker           det M passes 1 while the multipliers are a complex pair: they leave the unit circle together
//! Hopf                     the end of a branch of self-excited motions, where the amplitude is zero
//! grazing                  the number of impacts in a period changes
//! centre                   a crossing with motions of every amplitude at one value of the parameter
//! ```
//!
//! (A. H. Nayfeh and B. Balachandran, *Applied Nonlinear Dynamics*, chapter 3; Y. A.
//! Kuznetsov, *Elements of Applied Bifurcation Theory*, Springer 2004.) In: two neighbouring points of a
//! branch with what is known there. Out: the point between them, by the root of the quantity that
//! changes its sign.

use super::balance::DrivenBalance;
use super::continuation::BranchNode;
use super::stability::Floquet;
use crate::numeric::ode::root::{BisectionStop, find_root, try_bisect};

/// The kind of a bifurcation on a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum BifurcationKind {
    /// The branch turns back: beyond it there is no such motion, and it jumps.
    Fold,
    /// Another branch crosses: often one of less symmetry.
    BranchPoint,
    /// A branch of motions of twice the period begins.
    PeriodDoubling,
    /// A second frequency appears.
    NeimarkSacker,
    /// A self-excited motion is born from rest.
    Hopf,
    /// Motions of every amplitude exist here, because a free undamped motion has a commensurable
    /// period.
    Centre,
    /// The motion touches a wall: on one side of it there is an impact more in a period.
    Grazing,
}

impl BifurcationKind {
    /// Every kind.
    pub const ALL: [Self; 7] = [
        Self::Fold,
        Self::BranchPoint,
        Self::PeriodDoubling,
        Self::NeimarkSacker,
        Self::Hopf,
        Self::Centre,
        Self::Grazing,
    ];

    /// Its name in documents: `period-doubling`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::BranchPoint => "branch-point",
            Self::PeriodDoubling => "period-doubling",
            Self::NeimarkSacker => "neimark-sacker",
            Self::Hopf => "hopf",
            Self::Centre => "centre",
            Self::Grazing => "grazing",
        }
    }
}

/// The test function of a kind of bifurcation, which changes its sign there; `None` if it has no
/// value at this point.
fn test(kind: BifurcationKind, node: &BranchNode, floquet: Option<Floquet>) -> Option<f64> {
    let (trace, determinant) = match floquet {
        Some(floquet) => (floquet.monodromy.trace(), floquet.monodromy.determinant()),
        None => (f64::NAN, f64::NAN),
    };
    let value = match kind {
        BifurcationKind::Fold => node.parameter_slope(),
        BifurcationKind::BranchPoint => node.orientation,
        BifurcationKind::PeriodDoubling => 1.0 + trace + determinant,
        BifurcationKind::NeimarkSacker => determinant - 1.0,
        // One lies at the end of a branch, where continuation finds it; the other is a crossing of
        // branches; walls are those of coupled equations.
        BifurcationKind::Hopf | BifurcationKind::Centre | BifurcationKind::Grazing => f64::NAN,
    };
    value.is_finite().then_some(value)
}

/// The bifurcations between two neighbouring points, each with its point on the branch. `between`
/// gives the point at a fraction of the way, `floquet` the multipliers of a point.
pub fn between(
    balance: &DrivenBalance,
    [from, to]: [(&BranchNode, Option<Floquet>); 2],
    between: &impl Fn(f64) -> Option<BranchNode>,
    floquet: &impl Fn(&BranchNode) -> Option<Floquet>,
) -> Vec<(BifurcationKind, BranchNode)> {
    use BifurcationKind::{BranchPoint, Fold, NeimarkSacker, PeriodDoubling};
    /// A determinant that stays this close to 1 is that of a motion without damping.
    const CONSERVED: f64 = 1e-6;
    let mut found = Vec::new();
    // The multipliers of a self-excited motion stay on the positive side.
    let kinds = match balance.driven.self_excited {
        true => &[BranchPoint, Fold][..],
        false => &[BranchPoint, Fold, PeriodDoubling, NeimarkSacker],
    };
    for &kind in kinds {
        let (Some(before), Some(after)) = (test(kind, from.0, from.1), test(kind, to.0, to.1))
        else {
            continue;
        };
        if before * after >= 0.0 {
            continue;
        }
        // The determinants of a balance and of shooting have signs of their own.
        if kind == BranchPoint && from.0.truth.is_some() != to.0.truth.is_some() {
            continue;
        }
        if kind == NeimarkSacker {
            let determinants = before.abs().max(after.abs());
            let complex = [from.1, to.1].into_iter().flatten().all(|floquet| {
                let trace = floquet.monodromy.trace();
                trace * trace < 4.0 * floquet.monodromy.determinant()
            });
            if determinants < CONSERVED || !complex {
                continue;
            }
        }
        let value = |part: f64| {
            let node = if part == 0.0 {
                Some(from.0.clone())
            } else if part == 1.0 {
                Some(to.0.clone())
            } else {
                between(part)
            };
            let node = node.as_ref();
            let multipliers =
                node.filter(|_| matches!(kind, PeriodDoubling | NeimarkSacker)).and_then(floquet);
            node.and_then(|node| test(kind, node, multipliers)).unwrap_or(f64::NAN)
        };
        let part = match kind {
            // The test function is only a sign, so that it is bisected.
            BranchPoint => Some(bisect_sign_change(value)),
            _ => find_root(value, 0.0, 1.0).ok(),
        };
        // At a branch point the Jacobian is singular and Newton's method may not converge; a point
        // slightly beside it is near enough.
        const BESIDE: [f64; 5] = [0.0, 1e-6, -1e-6, 1e-3, -1e-3];
        let beside =
            |part: f64| BESIDE.iter().find_map(|aside| between((part + aside).clamp(0.0, 1.0)));
        // An orbit by shooting that begins to touch a stiff stop is a corner of its branch: where it
        // turns back there is no point in between to be found, and it is itself the fold.
        let at_corner = || {
            let is_shot = [from, to].iter().all(|(node, _)| node.truth.is_some());
            let is_corner = kind == Fold && is_shot && balance.driven.jumps() == 0;
            let from_is_last = (from.0.parameter - to.0.parameter) * before > 0.0;
            is_corner.then(|| if from_is_last { from.0.clone() } else { to.0.clone() })
        };
        let Some(mut node) = part.and_then(beside).or_else(at_corner) else {
            continue;
        };
        // On a crossing the equations have two independent tangents: that of this branch is along the
        // way from one point to the other.
        node.tangent = from.0.way_to(to.0);
        // A branch that begins at a crossing turns back there without a fold of its own, but the
        // turn is easier to locate.
        let crossing = found.iter().position(|(other, _)| kind == Fold && *other == BranchPoint);
        match crossing {
            Some(index) => found[index] = (BranchPoint, node),
            None => found.push((kind, node)),
        }
    }
    found
}

/// Bisects the sign change of a function between 0 and 1, to 1e-9.
pub(super) fn bisect_sign_change(mut value: impl FnMut(f64) -> f64) -> f64 {
    let before = value(0.0);
    let is_before = |part: f64| match value(part) {
        // Here the branch cannot be distinguished from the other one, which is close enough.
        there if there.is_nan() => Err(part),
        there => Ok(there * before > 0.0),
    };
    match try_bisect(is_before, 0.0, 1.0, BisectionStop::Halvings(30)) {
        Ok([low, high]) => 0.5 * (low + high),
        Err(part) => part,
    }
}

//! Folds that only the truncated balance has.
//!
//! ```text
//! det(1 - M) changes its sign where a multiplier of the true motion passes 1: at its folds, and where branches cross
//! ```
//!
//! If a motion has sharp turns, the branch of its balance oscillates about that of the true motion,
//! and near the top of a resonance, where the parameter hardly changes, each oscillation makes a
//! spurious fold. In: the points of a branch with the true motions beside them, and its folds. Out:
//! the folds that the true motion does not have.

use super::bifurcation::BifurcationKind;
use super::continuation::BranchNode;
use super::judgement::PointJudgement;

/// A bifurcation between the point of this index and the next one.
pub(super) type LocatedBifurcation = (usize, BifurcationKind, BranchNode);

/// Folds of the balance alone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "ResponseRipple"))]
pub struct Ripple {
    /// How many they are.
    pub folds: usize,
    /// The lowest and the highest value of the parameter at which they are.
    pub range: [f64; 2],
}

impl Ripple {
    /// Adds the folds at these parameters to those that there are already.
    pub(super) fn merged_with(ripple: Option<Self>, parameters: &[f64]) -> Option<Self> {
        parameters.iter().fold(ripple, |ripple, parameter| {
            Some(match ripple {
                None => Self { folds: 1, range: [*parameter; 2] },
                Some(Self { folds, range: [low, high] }) => {
                    Self { folds: folds + 1, range: [low.min(*parameter), high.max(*parameter)] }
                }
            })
        })
    }
}

/// The sign that det(1 - M) has for most of the true motions near these points; zero if there are
/// none.
fn side(judged: &[PointJudgement]) -> f64 {
    let sign = |(_, truth): &PointJudgement| {
        truth.map_or(0.0, |truth| {
            let away = nalgebra::Matrix2::identity() - truth.floquet.monodromy;
            let determinant: f64 = match truth.floquet.self_excited {
                true => away[(0, 0)],
                false => away.determinant(),
            };
            if determinant == 0.0 { 0.0 } else { determinant.signum() }
        })
    };
    let sum: f64 = judged.iter().map(sign).sum();
    if sum == 0.0 { 0.0 } else { sum.signum() }
}

/// The bifurcations of a branch without the folds that only its balance has, and the parameters of
/// those folds.
pub(super) fn without_ripple(
    found: Vec<LocatedBifurcation>,
    nodes: &[BranchNode],
    judged: &[PointJudgement],
) -> (Vec<LocatedBifurcation>, Vec<f64>) {
    let (mut kept, mut left_out) = (Vec::new(), Vec::new());
    let mut from = 0;
    let mut rest = found.into_iter().peekable();
    while rest.peek().is_some() {
        // The sign changes at branch points, too.
        let mut folds = Vec::new();
        let mut to = nodes.len();
        for place in rest.by_ref() {
            match place.1 {
                BifurcationKind::Fold if place.2.truth.is_none() => folds.push(place),
                BifurcationKind::BranchPoint => {
                    to = place.0 + 1;
                    kept.push(place);
                    break;
                }
                _ => kept.push(place),
            }
        }
        match of_true_motion(&folds, nodes, judged, [from, to]) {
            Some(real) => {
                let parameters = folds.iter().map(|(_, _, node)| node.parameter);
                let others = parameters.filter(|parameter| {
                    real.iter().all(|(_, _, node)| node.parameter != *parameter)
                });
                left_out.extend(others);
                kept.extend(real);
            }
            None => kept.append(&mut folds),
        }
        from = to;
    }
    kept.sort_by_key(|(index, _, _)| *index);
    (kept, left_out)
}

/// The folds of the true motion in place of these of a balance, on a part of a branch without
/// crossings; `None` if all of these are real, or if the true motions do not decide. On either side
/// of a fold of the true motion det(1 - M) has one sign each: where the balance turns more often
/// than the sign, its folds are as many as the sign changes, each where the branch comes farthest
/// in between.
fn of_true_motion(
    folds: &[LocatedBifurcation],
    nodes: &[BranchNode],
    judged: &[PointJudgement],
    [from, to]: [usize; 2],
) -> Option<Vec<LocatedBifurcation>> {
    // Before the first fold, between one and the next, behind the last.
    let begins = std::iter::once(from).chain(folds.iter().map(|fold| fold.0 + 1));
    let ends = folds.iter().map(|fold| fold.0 + 1).chain([to]);
    let sides: Vec<f64> = begins
        .zip(ends)
        .map(|(begin, end)| side(judged.get(begin..end).unwrap_or_default()))
        .collect();
    let (first, last) = (*sides.first()?, *sides.last()?);
    let mut turns: Vec<usize> = Vec::new();
    let mut before = first;
    for (fold, behind) in sides.iter().skip(1).enumerate() {
        if before * behind < 0.0 {
            turns.push(fold);
        }
        before = if *behind == 0.0 { before } else { *behind };
    }
    let left_out = folds.len() - turns.len();
    // Spurious folds come in pairs, between which the branch turns back and forth.
    if left_out == 0 || left_out % 2 == 1 || first * last == 0.0 {
        return None;
    }
    let mut direction = nodes.get(from)?.parameter_slope().signum();
    let mut real = Vec::new();
    for index in 0..turns.len() {
        let begin = index.checked_sub(1).map_or(from, |before| folds[turns[before]].0 + 1);
        let end = turns.get(index + 1).map_or(to, |behind| folds[*behind].0 + 1);
        let points = (begin..end)
            .filter_map(|index| Some((index, BifurcationKind::Fold, nodes.get(index)?)));
        let places = folds.iter().map(|(index, kind, node)| (*index, *kind, node));
        let places = places.filter(|(index, _, _)| (begin..end).contains(index));
        let ahead = |node: &BranchNode| direction * node.parameter;
        let farthest =
            points.chain(places).max_by(|one, other| ahead(one.2).total_cmp(&ahead(other.2)));
        real.extend(farthest.map(|(index, kind, node)| (index, kind, node.clone())));
        direction = -direction;
    }
    Some(real)
}

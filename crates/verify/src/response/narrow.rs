//! Intervals of instability that are narrower than a step along a branch.
//!
//! ```text
//! d_+ = det(1 - M) = 1 - tr M + det M,   d_- = det(1 + M) = 1 + tr M + det M
//! ```
//!
//! A fold, a branch point or a period doubling is found where d_+ or d_- changes its sign between two
//! points. At two of them within a step, such as the edges of a tongue of a parametric resonance, it
//! has the same sign at both points. But tr M and det M depend smoothly on the parameter, so that
//! three points show where d has a minimum: points are added there, by parabolas, until one lies
//! within the interval or d is found to stay positive. First, points are added where the
//! multipliers turn so far within a step that three points would not show it.
//!
//! In: the points of a branch with their multipliers. Out: the same with further points among them.

use nalgebra::Matrix2;

use super::PreparedRequest;
use super::balance::DrivenBalance;
use super::continuation::BranchNode;
use super::judgement::PointJudgement;
use super::stability::Floquet;

/// A point of a branch with what is known there.
type JudgedPoint = (BranchNode, PointJudgement);

/// A point between two of a branch, at this fraction of the way.
type Between<'a> = &'a dyn Fn(&BranchNode, &BranchNode, f64) -> Option<BranchNode>;

/// det(1 - sign M).
fn determinant(sign: f64, judged: &PointJudgement) -> Option<f64> {
    let (floquet, _) = judged;
    let value: f64 = (Matrix2::identity() - floquet.as_ref()?.monodromy * sign).determinant();
    value.is_finite().then_some(value)
}

/// The cosine of the angle of the multipliers, if they are a complex pair.
fn cosine(floquet: &Floquet) -> Option<f64> {
    let cosine = 0.5 * floquet.monodromy.trace() / floquet.monodromy.determinant().sqrt();
    (cosine.abs() < 1.0).then_some(cosine)
}

/// Newton's divided differences of first and second order through three points.
fn differences([one, two, three]: [[f64; 2]; 3]) -> [f64; 2] {
    let slope = |from: [f64; 2], to: [f64; 2]| (to[1] - from[1]) / (to[0] - from[0]);
    let first = slope(one, two);
    [first, (slope(two, three) - first) / (three[0] - one[0])]
}

/// The place at which the parabola through three points is least, and its value there; `None` if it
/// has no minimum.
fn minimum(points: [[f64; 2]; 3]) -> Option<[f64; 2]> {
    let [first, second] = differences(points);
    let [one, two, _] = points;
    let place = 0.5 * (one[0] + two[0]) - 0.5 * first / second;
    let value = one[1] + (place - one[0]) * (first + second * (place - two[0]));
    (second > 0.0 && value.is_finite()).then_some([place, value])
}

impl PreparedRequest<'_> {
    /// Adds points to a branch wherever its multipliers could be 1 or -1 between two of them.
    pub(super) fn add_narrow(
        &self,
        balance: &DrivenBalance,
        points: Vec<JudgedPoint>,
        between: Between,
    ) -> Vec<JudgedPoint> {
        if self.driven.self_excited || self.driven.jumps() > 0 {
            return points;
        }
        let mut points = self.with_small_turns(balance, points, between);
        for sign in [1.0, -1.0] {
            let mut index = 1;
            while index + 1 < points.len() {
                let found =
                    self.instability(balance, &points[index - 1..=index + 1], sign, between);
                if let Some((place, found)) = found {
                    points.insert(index + place, found);
                    // The triple that begins with the new point is the next one.
                    index += 2;
                }
                index += 1;
            }
        }
        points
    }

    /// Adds points until the angle of the multipliers changes little from one to the next.
    fn with_small_turns(
        &self,
        balance: &DrivenBalance,
        points: Vec<JudgedPoint>,
        between: Between,
    ) -> Vec<JudgedPoint> {
        /// Largest change of the cosine of the angle.
        const TURN: f64 = 0.5;
        /// Largest number of points that are added, and of halvings of a step.
        const MOST: usize = 200;
        const HALVINGS: usize = 5;
        let mut points = points;
        let most = points.len() + MOST;
        for _ in 0..HALVINGS {
            let mut finer: Vec<JudgedPoint> = Vec::with_capacity(points.len());
            let count = points.len();
            for point in points {
                let turned = finer.last().and_then(|last: &JudgedPoint| {
                    let [from, to] = [last, &point].map(|point| cosine(point.1.0.as_ref()?));
                    Some((to? - from?).abs())
                });
                let is_far = turned.is_some_and(|turned| turned > TURN) && finer.len() < most;
                if let Some(last) = finer.last().filter(|_| is_far) {
                    finer.extend(self.judged_between(balance, [last, &point], 0.5, between));
                }
                finer.push(point);
            }
            let is_done = finer.len() == count;
            points = finer;
            if is_done {
                break;
            }
        }
        points
    }

    /// A point with its judgement, at this fraction of the way between two.
    fn judged_between(
        &self,
        balance: &DrivenBalance,
        [from, to]: [&JudgedPoint; 2],
        part: f64,
        between: Between,
    ) -> Option<JudgedPoint> {
        if self.question.interrupt.is_requested() {
            return None;
        }
        let node = between(&from.0, &to.0, part)?;
        let judged = self.judged(balance, &node);
        Some((node, judged))
    }

    /// A point at which det(1 - sign M) is negative, between three at which it is positive, and
    /// whether it belongs before the middle one (0) or behind it (1); `None` if none is found.
    fn instability(
        &self,
        balance: &DrivenBalance,
        points: &[JudgedPoint],
        sign: f64,
        between: Between,
    ) -> Option<(usize, JudgedPoint)> {
        /// Ratio to the largest of the three values below which a minimum is looked at.
        const LOW: f64 = 0.1;
        /// Below this a value is known to be negative.
        const NEGATIVE: f64 = -1e-8;
        /// Largest number of points that are tried, and the change of the place, relative to the
        /// distance of the outer points, below which it is known.
        const MOST: usize = 8;
        const SETTLED: f64 = 1e-7;
        let at = |point: &JudgedPoint| Some([point.0.parameter, determinant(sign, &point.1)?]);
        let [one, two, three] = points else { return None };
        let mut known = [at(one)?, at(two)?, at(three)?];
        let largest = known.iter().map(|point| point[1]).fold(0.0, f64::max);
        let is_positive = known.iter().all(|point| point[1] > 0.0);
        let [from, middle, to] = known.map(|point| point[0]);
        if !is_positive || (middle - from) * (to - middle) <= 0.0 {
            return None;
        }
        let mut before = f64::INFINITY;
        for _ in 0..MOST {
            let [place, least] = minimum(known)?;
            let is_inside = (place - from) * (to - place) > 0.0;
            let is_settled = (place - before).abs() <= SETTLED * (to - from).abs();
            if !is_inside || least > LOW * largest || is_settled {
                return None;
            }
            before = place;
            let side = usize::from((place - middle) * (to - middle) > 0.0);
            let (first, second) = (&points[side], &points[side + 1]);
            let part = first.0.part_of_way(&second.0, place)?;
            let found = self.judged_between(balance, [first, second], part, between)?;
            let new = at(&found)?;
            if new[1] < NEGATIVE {
                return Some((side, found));
            }
            // The point that is farthest from the new one gives way to it.
            let far = |point: &[f64; 2]| (point[0] - new[0]).abs();
            let farthest = (0..3).max_by(|i, j| far(&known[*i]).total_cmp(&far(&known[*j])))?;
            if known.iter().any(|point| point[0] == new[0]) {
                return None;
            }
            known[farthest] = new;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::bifurcation::BifurcationKind;
    use crate::response::stability::multipliers_along;
    use crate::response::{ResponseRequest, respond};

    /// The tongue of `x'' + g x' + (1 - lambda cos 2wt) x + x^3` reaches from `1 - s` to `1 + s`,
    /// `s^2 = lambda^2/16 - g^2/4` to first order, which is less than a step along the branch of rest.
    /// At its edges, which the balance locates, a multiplier by integration is 1.
    #[test]
    fn a_tongue_narrower_than_a_step_is_found() {
        let (g, lambda) = (0.005_f64, 0.011_f64);
        let equation = format!("x'' + {g}*x' + (1 - {lambda}*cos(2*w*t))*x + x^3 = 0");
        let question = ResponseRequest::new(&equation, "w", [0.95, 1.05], "").expect("a request");
        let question = ResponseRequest { periods: 2, ..question };
        let response = respond(&question).expect("a response");
        assert_eq!(response.branches.len(), 3);
        let edges = response.bifurcations.iter();
        let edges = edges.filter(|found| found.kind == BifurcationKind::BranchPoint);
        let mut edges: Vec<f64> = edges.map(|found| found.parameter).collect();
        edges.sort_by(f64::total_cmp);
        assert_eq!(edges.len(), 2, "{edges:?}");
        let half = (lambda * lambda / 16.0 - g * g / 4.0).sqrt();
        for (edge, sign) in edges.iter().zip([-1.0, 1.0]) {
            assert!((edge - 1.0 - sign * half).abs() < 1e-5, "{edge}");
        }
        let asked = PreparedRequest::new(&question, question.equations.oscillator().expect("one"))
            .expect("a request");
        for (edge, sign) in edges.into_iter().zip([-1.0, 1.0]) {
            let away = |w: f64| {
                let floquet = multipliers_along(&asked.driven, w, w, |_| [0.0, 0.0]);
                let monodromy = floquet.expect("multipliers").monodromy;
                (Matrix2::identity() - monodromy).determinant()
            };
            assert!(away(edge - 1e-6) * sign < 0.0 && away(edge + 1e-6) * sign > 0.0, "{edge}");
        }
    }

    #[test]
    fn the_minimum_of_a_parabola() {
        let parabola = |x: f64| [x, 2.0 * (x - 0.3).powi(2) + 0.7];
        let [place, value] = minimum([0.0, 1.0, 2.5].map(parabola)).expect("a minimum");
        assert!((place - 0.3).abs() < 1e-14 && (value - 0.7).abs() < 1e-14);
        assert_eq!(minimum([0.0, 1.0, 2.0].map(|x: f64| [x, -x * x])), None);
    }
}

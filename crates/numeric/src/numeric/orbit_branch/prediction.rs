//! The guess of the next orbit of a branch.

use nalgebra::DVector;

use super::OrbitPoint;

/// The way from the last of these orbits to the next one at this distance, everything in these sizes; `tangent`
/// is that of the last orbit.
///
/// The cubic through the last two orbits with their tangents gives the distance s along the tangent. The branch
/// is a function of s with the slopes t/(t . tangent): the way aside continues the polynomial through so many
/// orbits, in Newton's form with each of them as a double node. An orbit is used if its terms are small beside
/// those of the one before.
pub(super) fn predicted<Kept>(
    points: &[OrbitPoint<Kept>],
    sizes: &DVector<f64>,
    tangent: &DVector<f64>,
    length: f64,
    most: usize,
) -> DVector<f64> {
    /// Least cosine of the angle between the tangent and that of an orbit that is used.
    const LEAST_COSINE: f64 = 0.5;
    /// Largest ratio of the terms of an orbit to those of the one before.
    const LARGEST_RATIO: f64 = 0.5;
    let along = |point: &OrbitPoint<Kept>| point.tangent.component_div(sizes).normalize();
    let [.., before, here] = points else { return tangent * length };
    let away = |point: &OrbitPoint<Kept>| (&point.unknowns - &here.unknowns).component_div(sizes);
    let (start, way) = (along(before), -away(before));
    let gone = way.norm();
    if gone == 0.0 {
        return tangent * length;
    }
    let chord = way / gone;
    let second = tangent * 2.0 + &start - &chord * 3.0;
    let third = tangent + &start - &chord * 2.0;
    let ratio = length / gone;
    let cubic = tangent * length + (second + third * ratio) * (ratio * length);
    if most <= 2 {
        return cubic;
    }
    let reach = cubic.dot(tangent);
    let (mut ahead, mut factor, mut largest) = (DVector::zeros(sizes.len()), 1.0, f64::INFINITY);
    let mut nodes: Vec<f64> = Vec::new();
    // The divided differences of one node and more that end at the last node.
    let mut differences: Vec<DVector<f64>> = Vec::new();
    for point in points.iter().rev().take(most) {
        let (place, slope) = (away(point), along(point));
        let (node, cosine) = (place.dot(tangent), slope.dot(tangent));
        if cosine < LEAST_COSINE || nodes.last().is_some_and(|last| node >= *last) {
            break;
        }
        let slope = slope / cosine;
        let mut terms = DVector::zeros(sizes.len());
        for is_second in [false, true] {
            let mut ending = vec![place.clone()];
            for (index, (known, other)) in differences.iter().zip(nodes.iter().rev()).enumerate() {
                let is_slope = is_second && index == 0;
                ending.push(match is_slope {
                    true => slope.clone(),
                    false => (&ending[index] - known) / (node - other),
                });
            }
            terms += &ending[ending.len() - 1] * factor;
            factor *= reach - node;
            nodes.push(node);
            differences = ending;
        }
        let size = terms.norm();
        if size.is_nan() || size > LARGEST_RATIO * largest {
            break;
        }
        ahead += terms;
        largest = size;
    }
    // Where nothing but the tangent was used, the branch turns sharply.
    if largest >= reach { cubic } else { ahead }
}

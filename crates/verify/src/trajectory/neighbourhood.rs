//! Neighbourhoods of motions that repeat themselves on a section once a period of the drive, from which all other
//! motions come nearer to them with every return.
//!
//! ```text
//! F:  the map of the states over n periods,  z = F(z),  M = F'(z)
//! P = Q + A^T P A,  A = M/rho,  rho between the spectral radius of M and 1:   |M d| <= rho |d| in |d|^2 = d^T P d
//! |F(y) - F(z)| <= L(r) |y - z|,  L(r) the largest |F'| in the ball |y - z| <= r;  L(r) < 1: no motion leaves it
//! ```
//!
//! (The mean value theorem, and Stein's equation for P: N. J. Higham, *Functions of Matrices*, SIAM 2008, section
//! B.14.) L(r) is sampled: it is the largest norm of the monodromy matrices of motions that begin on spheres of radii
//! up to r, in the directions of the axes and between two of them. In: the equations, smooth and
//! periodic in time; the state z. Out: the balls with L < 0.95, nested. Cost: n periods with their variations for each of
//! the 2 d^2 places, d states, on each of some twenty spheres.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use crate::expr::{Expr, Function, Node};
use crate::parallel::par_map;
use crate::symbol::Symbol;
use crate::system::{LANES, PathEnd, SideBySide, Solver, System, SystemOptions, Variations};

/// The map of the states over a period, with its derivative.
pub(super) struct PeriodMap {
    varied: Solver,
    period: f64,
    states: usize,
}

impl PeriodMap {
    /// The map of equations that have this period in `t`; `None` unless they are smooth everywhere and have it.
    pub(super) fn new(
        states: &[Symbol],
        right: &[Expr],
        values: &BTreeMap<Symbol, f64>,
        period: f64,
        options: &SystemOptions,
    ) -> Option<Self> {
        let fits = |right: &Expr| right.is_smooth_everywhere() && has_period(right, values, period);
        if !right.iter().all(fits) {
            return None;
        }
        let taken: Vec<Symbol> = values.keys().copied().collect();
        let varied = Variations::new(states, right, None, &taken).ok()?;
        let system = System::new(&varied.states, Symbol::new("t"), &varied.right, values).ok()?;
        Some(Self { varied: system.solver(&[], options), period, states: states.len() })
    }

    /// The derivatives of the map over this many periods at these states; `None` where a motion ends early.
    fn derivatives(&self, starts: &[DVector<f64>], periods: usize) -> Option<Vec<DMatrix<f64>>> {
        let derivatives = |starts: &&[DVector<f64>]| {
            let mut side_by_side = SideBySide::default();
            let mut states: Vec<Vec<f64>> =
                starts.iter().map(|start| start.as_slice().to_vec()).collect();
            let mut products = vec![DMatrix::identity(self.states, self.states); starts.len()];
            // Each period begins with unit variations: those of many would be large or small.
            for _ in 0..periods {
                let begin: Vec<Vec<f64>> =
                    states.iter().map(|state| Variations::start(state, false)).collect();
                let flights: Vec<_> = begin
                    .iter()
                    .map(|begin| (&self.varied, [0.0, self.period], begin.as_slice()))
                    .collect();
                let paths = side_by_side.solve(&flights);
                for ((path, state), product) in
                    paths.into_iter().zip(&mut states).zip(&mut products)
                {
                    let path = path.ok().filter(|path| path.reason() == PathEnd::Reached)?;
                    let (end, columns) = path.last_states().split_at_checked(self.states)?;
                    state.copy_from_slice(end);
                    let own = DMatrix::from_column_slice(self.states, self.states, columns);
                    *product = own * &*product;
                }
            }
            Some(products)
        };
        let groups: Vec<&[DVector<f64>]> = starts.chunks(LANES).collect();
        let all: Option<Vec<_>> = par_map(&groups, derivatives).into_iter().collect();
        Some(all?.concat())
    }
}

/// Whether an expression in which the other symbols are states has this period in `t`, which then stands in sines
/// and cosines alone whose arguments grow by multiples of 2 pi in it, to rounding.
fn has_period(expression: &Expr, values: &BTreeMap<Symbol, f64>, period: f64) -> bool {
    const ROUNDING: f64 = 1e-12;
    let time = Symbol::new("t");
    if !expression.contains(time) {
        return true;
    }
    let rate = match expression.node() {
        Node::Function(Function::Sin | Function::Cos, arguments) => {
            arguments.first().and_then(|argument| argument.differentiate(time).ok())
        }
        _ => None,
    };
    // A rate with a state or the time in it has no value.
    if let Some(rate) = rate.and_then(|rate| rate.evaluate(values).ok()) {
        let turns = rate * period / std::f64::consts::TAU;
        if (turns - turns.round()).abs() <= ROUNDING * turns.abs() {
            return true;
        }
    }
    expression.as_symbol() != Some(time)
        && expression.children().all(|part| has_period(part, values, period))
}

/// Balls about a state of a motion that repeats itself.
pub(super) struct Neighbourhood {
    centre: DVector<f64>,
    /// The number of periods after which it returns.
    pub(super) returns_after: usize,
    /// The matrix U of the norm |U d|.
    norm: DMatrix<f64>,
    /// The largest change of each state in the ball of radius 1.
    spread: Vec<f64>,
    /// The radii of the balls, increasing, and by how much a motion in them comes nearer with each return.
    balls: Vec<(f64, f64)>,
}

impl Neighbourhood {
    /// The neighbourhood of a state to which motion returns after so many periods; `sizes` are those
    /// of the states. `None` if nearby motions do not come nearer.
    pub(super) fn new(
        map: &PeriodMap,
        centre: &[f64],
        returns_after: usize,
        sizes: &[f64],
    ) -> Option<Self> {
        /// The largest contraction: a twentieth is left for what lies between the samples.
        const LARGEST: f64 = 0.95;
        /// The radius of the smallest ball, of which the states change by less than this part of their sizes.
        const SMALLEST: f64 = 1e-3;
        const BALLS: i32 = 24;
        let centre = DVector::from_column_slice(centre);
        let derivative = map.derivatives(std::slice::from_ref(&centre), returns_after)?.pop()?;
        let norm = contracting_norm(&derivative, sizes)?;
        let back = norm.clone().try_inverse()?;
        let size = |derivative: &DMatrix<f64>| {
            (&norm * derivative * &back).singular_values().iter().copied().fold(0.0, f64::max)
        };
        let mut contraction = size(&derivative);
        let directions = directions(centre.len());
        let mut balls = Vec::new();
        for index in 0..BALLS {
            let radius = SMALLEST * 2.0_f64.powf(0.5 * f64::from(index));
            let place = |direction: &DVector<f64>| &centre + &back * direction * radius;
            let places: Vec<DVector<f64>> = directions.iter().map(place).collect();
            let Some(derivatives) = map.derivatives(&places, returns_after) else { break };
            contraction = derivatives.iter().map(size).fold(contraction, f64::max);
            if contraction.is_nan() || contraction > LARGEST {
                break;
            }
            balls.push((radius, contraction));
        }
        let spread = back.row_iter().map(|row| row.norm()).collect();
        (!balls.is_empty()).then_some(Self { centre, returns_after, norm, spread, balls })
    }

    /// The distance of a state from the centre in the largest ball; `None` outside of it.
    pub(super) fn distance(&self, state: &[f64]) -> Option<f64> {
        let (largest, _) = self.balls.last()?;
        let distance = (&self.norm * (DVector::from_column_slice(state) - &self.centre)).norm();
        (distance <= *largest).then_some(distance)
    }

    /// A bound of the distance from the motion after so many returns.
    pub(super) fn distance_after(&self, returns: usize, mut distance: f64) -> f64 {
        for _ in 0..returns {
            let Some(contraction) = self.contraction(distance) else { return f64::INFINITY };
            // A distance that counts as none everywhere.
            if distance < 1e-100 {
                break;
            }
            distance *= contraction;
        }
        distance
    }

    /// By how much a motion at this distance comes nearer with each return; `None` outside of the largest ball.
    pub(super) fn contraction(&self, distance: f64) -> Option<f64> {
        let ball = self.balls.iter().find(|(radius, _)| distance <= *radius);
        ball.map(|(_, contraction)| *contraction)
    }

    /// The largest change of a state, in its size, at this distance.
    pub(super) fn largest_change(&self, distance: f64, sizes: &[f64]) -> f64 {
        let of_state = |(spread, size): (&f64, &f64)| spread * distance / size;
        self.spread.iter().zip(sizes).map(of_state).fold(0.0, f64::max)
    }
}

/// The matrix U of a norm |U d| in which a matrix contracts nearly as much as its spectral radius says; `None` if that
/// is not below one. U begins as the diagonal of the inverse sizes.
fn contracting_norm(matrix: &DMatrix<f64>, sizes: &[f64]) -> Option<DMatrix<f64>> {
    /// Power of the spectral radius to which the matrix contracts.
    const POWER: f64 = 0.9;
    const LEAST: f64 = 1e-3;
    const DOUBLINGS: usize = 60;
    let eigenvalues = matrix.complex_eigenvalues();
    let radius = eigenvalues.iter().map(|value| value.norm()).fold(0.0, f64::max);
    if radius.is_nan() || radius >= 1.0 {
        return None;
    }
    let mut power = matrix / radius.max(LEAST).powf(POWER);
    let squares = sizes.iter().map(|size| (size * size).recip());
    let mut sum = DMatrix::from_diagonal(&DVector::from_iterator(sizes.len(), squares));
    // 2, 4, 8, ... terms of the sum of (A^T)^k Q A^k.
    for _ in 0..DOUBLINGS {
        let more = power.transpose() * &sum * &power;
        let is_rest = more.norm() <= f64::EPSILON * sum.norm();
        sum += more;
        power = &power * &power;
        if is_rest {
            break;
        }
    }
    Some(sum.cholesky()?.l().transpose())
}

/// The unit vectors along the axes and in the middle between two of them, both ways.
fn directions(count: usize) -> Vec<DVector<f64>> {
    let unit = |index: usize| {
        let mut unit = DVector::zeros(count);
        unit[index] = 1.0;
        unit
    };
    let mut all: Vec<DVector<f64>> = (0..count).map(unit).collect();
    for first in 0..count {
        for second in 0..first {
            all.push((unit(first) + unit(second)).normalize());
            all.push((unit(first) - unit(second)).normalize());
        }
    }
    all.iter().flat_map(|direction| [direction.clone(), -direction]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;

    fn map(force: &str, period: f64) -> Option<PeriodMap> {
        let right = ["v", force].map(|text| parse_expression(text).expect("an expression"));
        let states = ["x", "v"].map(Symbol::new);
        PeriodMap::new(&states, &right, &BTreeMap::new(), period, &SystemOptions::default())
    }

    /// A linear oscillator contracts by exp(-zeta T) in its own norm everywhere, whatever its drive.
    #[test]
    fn a_linear_motion_contracts_everywhere() {
        let period = std::f64::consts::TAU / 1.5;
        let map = map("-x - v/5 + cos(3*t/2)", period).expect("a map");
        let own = Neighbourhood::new(&map, &[3.0, -2.0], 1, &[1.0, 1.0]).expect("balls");
        assert_eq!(own.balls.len(), 24);
        let expected = (-0.1 * period).exp();
        for (radius, contraction) in &own.balls {
            assert!(
                (expected..=expected.powf(0.9) + 1e-9).contains(contraction),
                "{radius} {contraction} {expected}"
            );
        }
    }

    /// No ball about the rest of x'' + x'/5 + x - x^3 = 0 reaches beyond the saddles at x = -1 and 1, and a motion on
    /// the largest one comes to rest.
    #[test]
    fn no_ball_reaches_beyond_a_saddle() {
        let map = map("-x - v/5 + x^3", 1.0).expect("a map");
        let own = Neighbourhood::new(&map, &[0.0, 0.0], 1, &[1.0, 1.0]).expect("balls");
        assert!(own.distance(&[0.1, 0.0]).is_some());
        for saddle in [-1.0, 1.0] {
            assert_eq!(own.distance(&[saddle, 0.0]), None);
        }
        let (radius, _) = *own.balls.last().expect("a ball");
        assert!(own.distance_after(400, radius) < 1e-8 * radius);
        assert_eq!(own.distance_after(1, 2.0 * radius), f64::INFINITY);
    }

    /// Repelling rest has no neighbourhood, and equations without the period of the section, or with corners, no map.
    #[test]
    fn what_does_not_contract_has_no_neighbourhood() {
        let period = std::f64::consts::TAU;
        let growing = map("-x + v/5", period).expect("a map");
        assert!(Neighbourhood::new(&growing, &[0.0, 0.0], 1, &[1.0, 1.0]).is_none());
        for force in ["-x - v/5 + cos(3*t/2)", "-x - t*v", "-x - v + exp(-t)", "-x - v - abs(x)"] {
            assert!(map(force, period).is_none(), "{force}");
        }
        for force in ["-x - v + cos(3*t)*exp(sin(t))", "-x - v*cos(x - 2*t)"] {
            assert!(map(force, period).is_some(), "{force}");
        }
    }
}

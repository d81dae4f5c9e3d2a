//! The start of a fit of any equation, from accelerations by local polynomials.
//!
//! At the samples, x, v and a follow from a polynomial of degree 4 through the neighbours. The parameters that fit
//! `a = a(x, v, t; p)` best need no integration.

use nalgebra::{DMatrix, DVector};

use crate::expr::CompiledList;
use crate::fit::laws::Law;
use crate::fit::least_squares::minimise;
use crate::fit::motion::Quantity;
use crate::fit::polynomial::LocalPolynomial;
use crate::fit::sample_fit::Samples;
use crate::fit::turning_points::Swings;
use crate::symbol::Symbol;

/// Coordinate, velocity and acceleration at a time.
type State = [f64; 3];

/// Local coordinate, velocity and acceleration at a time, without the centre of the swings.
fn local_state(samples: &Samples, swings: &Swings, time: f64) -> Option<State> {
    const SHARE: f64 = 0.35;
    const DEGREE: usize = 4;
    /// The samples on either side where those of a share of the swing are fewer: two more than the polynomial needs.
    const FEWEST: usize = 3;
    let times = &samples.times;
    let place = times.partition_point(|own| *own < time);
    let beside = |place: usize| times.get(place).map_or(0.0, |own| (own - time).abs());
    let few = beside(place.saturating_sub(FEWEST)).max(beside(place + FEWEST));
    let width = (SHARE * swings.half_period).max(few);
    let from = times.partition_point(|own| *own < time - width);
    let to = times.partition_point(|own| *own <= time + width);
    let (times, values) = (&samples.times[from..to], &samples.values[from..to]);
    let fit = LocalPolynomial::fit(times, values, time, width, DEGREE)?;
    let centre = swings.centre_at(time, 0.0);
    Some([fit.derivative(time, 0).0 - centre, fit.derivative(time, 1).0, fit.derivative(time, 2).0])
}

/// Initial coordinate and velocity at the first sample, offset and drift.
pub fn initial_state(samples: &Samples, swings: &Swings) -> [f64; 4] {
    let [level, drift] = samples.centre;
    let first = samples.times.first().copied().unwrap_or(0.0);
    let near = 0.35 * swings.half_period;
    let state = local_state(samples, swings, first + near);
    // Back to the first sample along the harmonic motion of this frequency.
    let rate = std::f64::consts::PI / swings.half_period;
    let [x, v] = state.map_or([0.0; 2], |[x, v, _]| {
        let (sine, cosine) = (rate * near).sin_cos();
        [x * cosine - v * sine / rate, v * cosine + x * rate * sine]
    });
    [x, v, level, drift]
}

/// The parameters of an equation that fit the accelerations of records of displacement best. Returns `None` if there are no such
/// records, or no parameters fit.
pub fn parameters(law: &Law, records: &[(&Samples, &Swings)]) -> Option<Vec<f64>> {
    const PLACES: usize = 400;
    const ITERATIONS: u64 = 200;
    let is_displacement =
        |(samples, _): &&(&Samples, &Swings)| samples.quantity == Quantity::Displacement;
    let states = records.iter().filter(is_displacement).flat_map(|(samples, swings)| {
        let stride = (samples.times.len() / PLACES).max(1);
        let times = samples.times.iter().step_by(stride);
        times.filter_map(|time| Some((*time, local_state(samples, swings, *time)?)))
    });
    let states: Vec<(f64, State)> = states.collect();
    if states.is_empty() {
        return None;
    }
    let (coordinate, time) = (law.coordinate, Symbol::new("t"));
    let velocity = coordinate.derivative();
    let mut values = vec![law.acceleration.clone()];
    for name in &law.parameters {
        values.push(law.acceleration.differentiate(*name).ok()?);
    }
    let arguments = [&[coordinate, velocity, time], law.parameters.as_slice()].concat();
    let compiled = CompiledList::new(&values, &arguments).ok()?;
    let width = law.parameters.len();
    let residuals = |parameters: &[f64]| {
        let mut residuals = DVector::zeros(states.len());
        let mut jacobian = DMatrix::zeros(states.len(), width);
        let (mut scratch, mut found) = (vec![], vec![0.0; width + 1]);
        for (row, (time, [x, v, a])) in states.iter().enumerate() {
            let point = [&[*x, *v, *time], parameters].concat();
            compiled.call(&point, &mut scratch, &mut found);
            residuals[row] = found[0] - a;
            for (column, slope) in found[1..].iter().enumerate() {
                jacobian[(row, column)] = *slope;
            }
        }
        let is_finite = residuals.iter().chain(jacobian.iter()).all(|value| value.is_finite());
        is_finite.then_some((residuals, jacobian))
    };
    // From several sizes of all parameters, since an equation may be far from linear in them.
    let found = [1.0, 0.1, 10.0, 0.01, 100.0].iter().filter_map(|size| {
        let first: Vec<f64> = (0..width).map(|index| size * (1.0 + 0.1 * index as f64)).collect();
        minimise(&first, ITERATIONS, residuals)
    });
    let best = found.min_by(|one, other| one.square().total_cmp(&other.square()))?;
    Some(best.parameters)
}

//! Coordinates of a law in which the valley of the sum of squares is straight.
//!
//! A record fixes the frequency at the amplitude S that it has far better than the two numbers of a spring. In these numbers its valley is curved, and
//! the method of Levenberg and Marquardt creeps along it. With the frequency W at S, and the equivalent viscous coefficient c
//! at the speed V = W S, it is not:
//!
//! ```text
//! w^2 = W^2 - 3/4 beta S^2                                   Duffing spring
//! w^2 = (W^2 + sqrt(W^4 + 10/3 (b S)^2))/2                   quadratic spring: W^2 = w^2 - 5/6 (b S/w)^2
//! k = W^2 S^(1-n)/h(n),  h(n) = 2 Gamma(n/2+1)/(sqrt(pi) Gamma(n/2+3/2))      power: first harmonic
//! r = c V^(1-p)/h(p)
//! ```

use nalgebra::DMatrix;
use spec_math::cephes64::gamma;

use crate::fit::laws::{Law, Loss, Spring};
use crate::fit::motion::Quantity;
use crate::fit::sample_fit::Samples;

/// The coordinates for a law of the list; the values themselves for an equation of one's own.
#[derive(Clone, Copy, Debug)]
pub struct FitCoordinates {
    parts: Option<(Spring, Loss)>,
    /// The amplitude S and the speed V.
    sizes: [f64; 2],
    /// The number of parameters of the law.
    shared: usize,
}

/// The first harmonic of `|cos|^e sgn(cos)`.
fn first_harmonic(exponent: f64) -> f64 {
    let half = 0.5 * exponent;
    2.0 * gamma(half + 1.0) / (std::f64::consts::PI.sqrt() * gamma(half + 1.5))
}

impl FitCoordinates {
    /// Coordinates at the root mean square of the amplitude of these records.
    pub fn new(law: &Law, records: &[&Samples]) -> Self {
        let (mut square, mut count, mut duration) = (0.0, 0, 0.0);
        for samples in records {
            let rate = std::f64::consts::PI / samples.half_period;
            let order = match samples.quantity {
                Quantity::Displacement => 0,
                Quantity::Velocity => 1,
                Quantity::Acceleration => 2,
            };
            let mean = samples.values.iter().sum::<f64>() / samples.values.len() as f64;
            let own: f64 = samples.values.iter().map(|value| (value - mean).powi(2)).sum();
            square += own / rate.powi(2 * order);
            count += samples.values.len();
            duration += samples.half_period;
        }
        let size = (2.0 * square / count.max(1) as f64).sqrt().max(f64::MIN_POSITIVE);
        let rate = std::f64::consts::PI * records.len() as f64 / duration;
        Self { parts: law.parts, sizes: [size, rate * size], shared: law.parameters.len() }
    }

    /// The parameters of the law, followed by the values of the records; `None` if there is no such spring.
    pub fn to_law(self, inner: &[f64]) -> Option<Vec<f64>> {
        let Some((spring, loss)) = self.parts else { return Some(inner.to_vec()) };
        let [size, speed] = self.sizes;
        let mut values = inner.to_vec();
        let (first, second) = (inner[0], inner[1]);
        let square = first * first;
        match spring {
            Spring::Linear | Spring::Pendulum => {}
            Spring::Duffing => values[0] = (square - 0.75 * second * size * size).sqrt(),
            Spring::Quadratic => {
                let bend = 10.0 / 3.0 * (second * size).powi(2);
                values[0] = (0.5 * (square + (square * square + bend).sqrt())).sqrt();
            }
            Spring::Power => {
                values[0] = square * size.powf(1.0 - second) / first_harmonic(second);
            }
        }
        if loss == Loss::Power {
            let [r, p] = [self.shared - 2, self.shared - 1];
            values[r] = inner[r] * speed.powf(1.0 - inner[p]) / first_harmonic(inner[p]);
        }
        values.iter().all(|value| value.is_finite()).then_some(values)
    }

    /// The coordinates of these parameters; `None` if the frequency at the amplitude S is not real.
    pub fn inner(self, values: &[f64]) -> Option<Vec<f64>> {
        let Some((spring, loss)) = self.parts else { return Some(values.to_vec()) };
        let [size, speed] = self.sizes;
        let mut inner = values.to_vec();
        let (first, second) = (values[0], values[1]);
        let square = first * first;
        match spring {
            Spring::Linear | Spring::Pendulum => {}
            Spring::Duffing => inner[0] = (square + 0.75 * second * size * size).sqrt(),
            Spring::Quadratic => {
                inner[0] = (square - 5.0 / 6.0 * (second * size / first).powi(2)).sqrt();
            }
            Spring::Power => {
                inner[0] = (first * first_harmonic(second) * size.powf(second - 1.0)).sqrt();
            }
        }
        if loss == Loss::Power {
            let [r, p] = [self.shared - 2, self.shared - 1];
            inner[r] = values[r] * first_harmonic(values[p]) * speed.powf(values[p] - 1.0);
        }
        inner.iter().all(|value| value.is_finite()).then_some(inner)
    }

    /// The derivatives of the parameters of the law by these coordinates, from central differences.
    pub fn slopes(self, inner: &[f64]) -> Option<DMatrix<f64>> {
        const STEP: f64 = 1e-5;
        let mut slopes = DMatrix::identity(inner.len(), inner.len());
        if self.parts.is_none() {
            return Some(slopes);
        }
        for column in 0..self.shared {
            let step = STEP * if inner[column] == 0.0 { 1.0 } else { inner[column].abs() };
            let [mut above, mut below] = [inner.to_vec(), inner.to_vec()];
            above[column] += step;
            below[column] -= step;
            let [above, below] = [self.to_law(&above)?, self.to_law(&below)?];
            for row in 0..self.shared {
                slopes[(row, column)] = (above[row] - below[row]) / (2.0 * step);
            }
        }
        Some(slopes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_lead_back_to_the_law() {
        let samples = Samples {
            times: (0..100).map(f64::from).collect(),
            values: (0..100).map(|index| 3.0 * f64::from(index).sin()).collect(),
            quantity: Quantity::Displacement,
            half_period: std::f64::consts::PI,
            middle: 50.0,
            centre: [0.0, 0.0],
            weight: 1.0,
        };
        for law in Law::list(true) {
            let values: Vec<f64> =
                (0..law.parameters.len() + 4).map(|index| 1.2 - 0.1 * index as f64).collect();
            let coordinates = FitCoordinates::new(&law, &[&samples]);
            let Some(inner) = coordinates.inner(&values) else {
                assert_eq!(law.parts.unwrap().0, Spring::Quadratic);
                continue;
            };
            let back = coordinates.to_law(&inner).unwrap();
            for (one, other) in values.iter().zip(&back) {
                assert!((one - other).abs() < 1e-12, "{}: {values:?} {back:?}", law.name);
            }
        }
    }
}

//! Methods of one term, series and their quotients, each from its definition in the literature:
//! omega^2 at one amplitude, without dimensions. The references are those at the head of the
//! method's file in `crates/oscillator/src/method/`.

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

use super::force::Force;
use super::quadrature::{integrate, solve};

/// What a definition gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// omega^2, and how far rounding in a fair evaluation may move it, relatively.
    Value(f64, f64),
    /// The same for a motion about another equilibrium, on which a method may be silent.
    Elsewhere(f64, f64),
    /// The definition has no value here: a motion through a pole, a fold of the branch, no limit at
    /// rest.
    Nothing(&'static str),
    /// This test cannot tell.
    Unknown,
}

/// Rounding of a sum that is `size` when its terms are taken positive, over its value.
const ROUNDING: f64 = 1e-14;

/// A motion about `origin`, released at `origin + amplitude`.
pub struct Question<'a> {
    pub force: &'a Force,
    pub origin: f64,
    pub amplitude: f64,
}

impl Question<'_> {
    pub fn f(&self, y: f64) -> f64 {
        self.force.rise(self.origin, y)
    }

    pub fn size(&self) -> f64 {
        self.amplitude.abs()
    }

    /// Whether the force is finite on the whole way of a motion of one term.
    fn reachable(&self) -> bool {
        let (low, high) = self.force.domain(self.origin);
        self.origin - self.size() > low && self.origin + self.size() < high
    }

    /// What rounding does to the force at this distance, relatively: of its terms, and of the
    /// equilibrium itself.
    pub fn noise(&self, y: f64) -> f64 {
        let x = self.origin + y;
        let moved =
            if self.origin == 0.0 { 0.0 } else { self.origin.abs() * self.force.slope(x).abs() };
        let terms = if self.origin == 0.0 {
            self.terms(y)
        } else {
            self.force.size(x) + self.force.size(self.origin)
        };
        (terms + moved) / self.f(y).abs()
    }

    fn terms(&self, y: f64) -> f64 {
        self.force.size(y)
    }

    pub fn given(&self, squared: f64, noise: f64) -> Answer {
        if squared.is_finite() && noise.is_finite() {
            Answer::Value(squared, ROUNDING * (10.0 + noise))
        } else if squared.is_finite() {
            // All that is left of its terms is rounding.
            Answer::Unknown
        } else {
            Answer::Nothing("the force overflows")
        }
    }

    /// Angles at which a motion of one term passes the places where the force turns fast.
    fn angles(&self) -> Vec<f64> {
        let mut angles = vec![0.0, 0.25 * PI, FRAC_PI_2, 0.75 * PI, PI];
        let cosines =
            self.force.places().into_iter().map(|place| (place - self.origin) / self.size());
        angles.extend(cosines.filter(|cosine| cosine.abs() < 1.0).map(f64::acos));
        angles.sort_by(f64::total_cmp);
        angles
    }

    /// `c_1/A = (2/(pi A)) int_0^pi f(A cos theta) cos theta dtheta`: iteration perturbation,
    /// parameter expansion, max-min, Hamiltonian and variational iteration.
    pub fn shared_integral(&self) -> Answer {
        if !self.reachable() {
            return Answer::Nothing("the motion of one term runs through a pole");
        }
        let size = self.size();
        let integrand = |theta: f64| self.f(size * theta.cos()) * theta.cos();
        let Some(value) = integrate(&integrand, &self.angles(), 1e-14) else {
            return Answer::Unknown;
        };
        let scale = |theta: f64| {
            let y = size * theta.cos();
            let force = self.f(y).abs();
            (force * (1.0 + 1e-2 * self.noise(y).min(1e12))) * theta.cos().abs()
        };
        let terms = integrate(&scale, &self.angles(), 1e-4).unwrap_or(f64::INFINITY);
        self.given(2.0 * value / (PI * size), 100.0 * terms / value.abs())
    }

    /// `4 [V(A) - V(A/sqrt 2)]/A^2`.
    pub fn energy_balance(&self) -> Answer {
        if !self.reachable() {
            return Answer::Nothing("the motion of one term runs through a pole");
        }
        let (from, to) = (self.size() / SQRT_2, self.size());
        let mut places = vec![from, to];
        places.extend(
            self.force
                .places()
                .into_iter()
                .map(|place| place - self.origin)
                .filter(|y| *y > from && *y < to),
        );
        places.sort_by(f64::total_cmp);
        let Some(rise) = integrate(&|y| self.f(y), &places, 1e-14) else {
            return Answer::Unknown;
        };
        let terms = integrate(&|y| self.force.size(self.origin + y), &places, 1e-4)
            .unwrap_or(f64::INFINITY);
        self.given(4.0 * rise / (to * to), terms / rise.abs())
    }

    /// `f(c A)/(c A)`, `c = sqrt(3)/2`.
    pub fn amplitude_frequency(&self) -> Answer {
        if !self.reachable() {
            return Answer::Nothing("the motion of one term runs through a pole");
        }
        let y = 0.5 * 3_f64.sqrt() * self.size();
        self.given(self.f(y) / y, self.noise(y))
    }

    /// `f'(A/2)`.
    pub fn frequency_formula(&self) -> Answer {
        let slope = self.force.slope(self.origin + 0.5 * self.size());
        let near =
            [0.5 - 1e-6, 0.5 + 1e-6].map(|part| self.force.slope(self.origin + part * self.size()));
        if near.iter().any(|value| (value - slope).abs() > 1e-2 * slope.abs()) {
            return Answer::Unknown;
        }
        // The slope is a difference of slopes of the terms.
        let terms: f64 = self
            .force
            .terms
            .iter()
            .map(|term| {
                let alone = Force { terms: vec![*term], ..self.force.clone() };
                alone.slope(self.origin + 0.5 * self.size()).abs()
            })
            .sum();
        self.given(slope, 1e2 * terms / slope.abs())
    }

    /// The Taylor coefficients of the force in units of the amplitude: `g_k = f_k A^(k-1)`, from
    /// the linear one on.
    pub fn scaled_taylor(&self, degree: usize) -> Option<Vec<f64>> {
        let series = self.force.taylor(self.origin, degree)?;
        let scaled: Vec<f64> = (0..=degree)
            .map(|k| if k == 0 { 0.0 } else { series[k] * self.amplitude.powi(k as i32 - 1) })
            .collect();
        scaled.iter().all(|value| value.is_finite()).then_some(scaled)
    }

    /// `omega^2 = sum e_k A^k`: each `e_k A^k`, through the period as a function of the energy.
    ///
    /// With `V = u^2/2` and `y = sum b_k u^k` the period is
    /// `2 pi sum (2j+1) b_(2j+1) (2j-1)!!/(2j)!! (2V)^j`: the integral of `dy/du` over a circle of
    /// radius `sqrt(2V)`.
    pub fn exact_series(&self, order: usize) -> Option<Vec<f64>> {
        let g = self.scaled_taylor(order + 1)?;
        if g[1] <= 0.0 {
            return None;
        }
        // 2V/(g_1 z^2) = 1 + ..., and u/z = its root.
        let square: Vec<f64> =
            (0..=order).map(|k| 2.0 * g[k + 1] / ((k + 2) as f64 * g[1])).collect();
        let root = power(&square, 0.5);
        // Lagrange: b_k = [z^(k-1)] (z/u)^k / k.
        let b = |k: usize| power(&root, -(k as f64))[k - 1] / k as f64;
        let mut period = vec![0.0; order + 1];
        let mut energy = vec![0.0; order + 1];
        energy[0] = 1.0;
        let mut weight = 1.0;
        for j in 0..=order / 2 {
            if j > 0 {
                weight *= (2 * j - 1) as f64 / (2 * j) as f64;
            }
            let factor = weight * (2 * j + 1) as f64 * b(2 * j + 1);
            for n in 2 * j..=order {
                period[n] += factor * energy[n - 2 * j];
            }
            energy = series_product(&energy, &square);
        }
        Some(power(&period, -2.0).into_iter().map(|value| g[1] * value).collect())
    }

    /// The series of omega^2 cut after a power of the amplitude.
    pub fn lindstedt_poincare(&self, order: usize) -> Answer {
        let Some(series) = self.exact_series(order) else {
            return Answer::Unknown;
        };
        let value: f64 = series.iter().sum();
        let terms: f64 = series.iter().map(|term| term.abs()).sum();
        self.given(value, 100.0 * terms / value.abs())
    }

    /// The quotient of polynomials that agrees with the exact series, in the squared amplitude
    /// where odd powers are absent. In a parameter, `step` is the power of the amplitude that goes
    /// with it.
    pub fn pade(&self, above: usize, below: usize, step: Option<usize>) -> Answer {
        let order = above + below;
        let Some(series) = self.exact_series(step.unwrap_or(2) * order) else {
            return Answer::Unknown;
        };
        let even = series.iter().skip(1).step_by(2).all(|value| *value == 0.0);
        let step = step.unwrap_or(if even { 2 } else { 1 });
        // Coefficients may grow fast: a scale makes them alike.
        let c: Vec<f64> = (0..=order).map(|k| series[step * k]).collect();
        let growth = (1..=order)
            .map(|k| (c[k] / c[0]).abs().powf(1.0 / k as f64))
            .fold(f64::MIN_POSITIVE, f64::max);
        let at = |k: i64| {
            if k < 0 { 0.0 } else { c[k as usize] / growth.powi(k as i32) }
        };
        let row = |k: i64| -> Vec<f64> {
            let (l, m) = (above as i64, below as i64);
            (1..=m).map(|j| at(l + k - j)).chain([-at(l + k)]).collect()
        };
        let Some(q) = solve((1..=below as i64).map(row).collect()) else {
            return Answer::Unknown;
        };
        let q: Vec<f64> = [1.0].into_iter().chain(q).collect();
        let p: Vec<f64> = (0..=above)
            .map(|i| (0..=i.min(below)).map(|j| q[j] * at(i as i64 - j as i64)).sum())
            .collect();
        let sum = |terms: &[f64]| -> (f64, f64) {
            let terms: Vec<f64> =
                terms.iter().enumerate().map(|(k, t)| t * growth.powi(k as i32)).collect();
            (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum())
        };
        let (numerator, denominator) = (sum(&p), sum(&q));
        let noise = numerator.1 / numerator.0.abs() + denominator.1 / denominator.0.abs();
        // Coefficients of a nearly singular system are rounding: what a change of the last digits
        // does is part of the noise.
        self.given(numerator.0 / denominator.0, 1e4 * noise)
    }

    pub fn is_odd(&self) -> bool {
        self.origin == 0.0 && self.force.is_odd()
    }
}

pub fn series_product(a: &[f64], b: &[f64]) -> Vec<f64> {
    (0..a.len()).map(|n| (0..=n).map(|k| a[k] * b[n - k]).sum()).collect()
}

/// The series of a power of a series (J. C. P. Miller's recurrence).
fn power(series: &[f64], exponent: f64) -> Vec<f64> {
    let mut result = vec![series[0].powf(exponent); series.len()];
    for n in 1..series.len() {
        let sum: f64 = (1..=n)
            .map(|k| (exponent * k as f64 - (n - k) as f64) * series[k] * result[n - k])
            .sum();
        result[n] = sum / (n as f64 * series[0]);
    }
    result
}

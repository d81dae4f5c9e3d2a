//! Methods that correct the motion again and again: homotopy perturbation, homotopy analysis,
//! iteration perturbation.

use std::f64::consts::PI;

use super::definitions::{Answer, Question, series_product};

impl Question<'_> {
    /// `1 = Om + a_1 + ... + a_n` in units of the linear force: the root that continues it from
    /// rest.
    pub fn homotopy_perturbation(&self, order: usize, degree: usize) -> Answer {
        let Some(g) = self.scaled_taylor(degree) else {
            return Answer::Unknown;
        };
        if g[1] <= 0.0 {
            return Answer::Unknown;
        }
        let wave = Waves::for_degree(degree, order);
        let relation = |part: f64, omega: f64| {
            let force: Vec<f64> = (0..=degree)
                .map(|k| if k < 2 { 0.0 } else { g[k] / g[1] * part.powi(k as i32 - 1) })
                .collect();
            omega + homotopy_corrections(&wave, &force, omega, order) - 1.0
        };
        // At first order the relation is linear in omega^2.
        let root = if order == 1 { Some(1.0 - relation(1.0, 1.0)) } else { follow(&relation, &g) };
        // What rounding of the terms, even powers included, moves the root by.
        let rounding = |omega: f64| {
            let sizes: f64 = g[1..].iter().map(|value| (value / g[1]).abs()).sum();
            let (h, terms) = (
                1e-6 * omega,
                (1..=order).map(|k| (sizes / omega.abs()).powi(k as i32)).sum::<f64>(),
            );
            let slope = (relation(1.0, omega + h) - relation(1.0, omega - h)) / (2.0 * h);
            1e2 * terms / slope.abs()
        };
        match root {
            Some(omega) => self.given(g[1] * omega, 1e3 + rounding(omega)),
            None => {
                Answer::Nothing("the branch from the linear frequency ends before this amplitude")
            }
        }
    }

    /// By how much of itself a given omega^2 misses `omega0^2 = omega^2 + a_1 + ... + a_n`,
    /// whatever the sign of the linear force.
    pub fn defect_of_homotopy(&self, order: usize, degree: usize, squared: f64) -> Option<f64> {
        let g = self.scaled_taylor(degree)?;
        let wave = Waves::for_degree(degree, order);
        let force: Vec<f64> = (0..=degree).map(|k| if k < 2 { 0.0 } else { g[k] }).collect();
        let relation =
            |omega: f64| omega + homotopy_corrections(&wave, &force, omega, order) - g[1];
        let h = 1e-6 * squared;
        let slope = (relation(squared + h) - relation(squared - h)) / (2.0 * h);
        Some((relation(squared) / slope / squared).abs()).filter(|defect| defect.is_finite())
    }

    /// `omega = w_0 + ... + w_(n-1)` of Liao's deformation equations, `n` at least one.
    pub fn homotopy_analysis(&self, order: usize, degree: usize, hbar: f64) -> Answer {
        let Some(g) = self.scaled_taylor(degree) else {
            return Answer::Unknown;
        };
        let scale = g.iter().map(|value| value.abs()).fold(f64::MIN_POSITIVE, f64::max);
        let g: Vec<f64> = g.iter().map(|value| value / scale).collect();
        let wave = Waves::for_degree(degree, order);
        let mut motions: Vec<Vec<f64>> = vec![wave.cosine(1)];
        let mut frequencies: Vec<f64> = Vec::new();
        // Rounding of the projections, even powers included.
        let mut rounding = 0.0;
        for m in 1..=order {
            // R_m without the frequency that it fixes.
            let forces = powers_of_series(&motions, m, &g);
            let mut right = forces[m - 1].clone();
            let accelerations: Vec<Vec<f64>> =
                motions.iter().map(|motion| wave.second_derivative(motion)).collect();
            let squared = |k: usize| -> f64 {
                (0..=k)
                    .map(|i| {
                        frequencies.get(i).unwrap_or(&0.0) * frequencies.get(k - i).unwrap_or(&0.0)
                    })
                    .sum()
            };
            for (j, acceleration) in accelerations.iter().enumerate().take(m) {
                let factor = squared(m - 1 - j);
                for (value, term) in right.iter_mut().zip(acceleration) {
                    *value += factor * term;
                }
            }
            let secular = wave.coefficient(&right, 1);
            let size = right.iter().map(|value| value.abs()).sum::<f64>() / right.len() as f64;
            if m == 1 {
                if secular.abs() <= 1e-12 * size {
                    return Answer::Unknown;
                }
                if secular <= 0.0 || secular.is_nan() {
                    return Answer::Value(scale * secular, 1e-9);
                }
                frequencies.push(secular.sqrt());
            } else {
                frequencies.push(secular / (2.0 * frequencies[0]));
            }
            rounding += size / (2.0 * frequencies[0]);
            if m == order {
                break;
            }
            // u_m = chi u_(m-1) + hbar L^-1 R_m, u_m(0) = 0.
            let w0 = frequencies[0] * frequencies[0];
            let mut next = wave.inverse(&right, hbar / w0);
            if m > 1 {
                let before = &motions[m - 1];
                // The first harmonic is fixed by u_m(0) = 0 alone, which u_(m-1) obeys already.
                for (value, term) in next.iter_mut().zip(before) {
                    *value += term;
                }
            }
            motions.push(next);
        }
        let omega: f64 = frequencies.iter().sum();
        let terms: f64 = frequencies.iter().map(|term| term.abs()).sum();
        if omega <= 0.0 {
            return Answer::Value(-1.0, 1e-9);
        }
        self.given(scale * omega * omega, 1e3 * (terms + rounding) / omega)
    }

    /// The second pass of iteration perturbation: no secular term in `Om x_1 - f(x_1)`, on the
    /// branch from rest.
    pub fn iteration_perturbation(&self, degree: usize) -> Answer {
        let Some(g) = self.scaled_taylor(degree) else {
            return Answer::Unknown;
        };
        if g[1] <= 0.0 {
            return Answer::Unknown;
        }
        let wave = Waves::for_degree(degree, degree);
        let start = wave.cosine(1);
        let relation = |part: f64, omega: f64| {
            let coefficient = |k: usize| {
                if k < 2 { g[k] / g[1] } else { g[k] / g[1] * part.powi(k as i32 - 1) }
            };
            let force = |x: &[f64]| -> Vec<f64> {
                x.iter()
                    .map(|&x| (1..=degree).rev().fold(0.0, |sum, k| (sum + coefficient(k)) * x))
                    .collect()
            };
            let first = force(&start);
            // x_1 = cos + sum_(k != 1) c_k (cos k - cos)/((k^2 - 1) omega^2)
            let mut motion = wave.inverse(&first, 1.0 / omega);
            motion.iter_mut().zip(&start).for_each(|(value, cosine)| *value = cosine - *value);
            let second = force(&motion);
            omega * wave.coefficient(&motion, 1) - wave.coefficient(&second, 1)
        };
        match follow(&relation, &g) {
            Some(omega) => self.given(g[1] * omega, 1e3),
            None => {
                Answer::Nothing("the branch from the linear frequency ends before this amplitude")
            }
        }
    }
}

/// Even periodic functions by their values at the points of half a period.
struct Waves {
    points: usize,
    highest: usize,
    /// `cos(pi j/(2 points))` for `j` below `4 points`.
    cosines: Vec<f64>,
}

impl Waves {
    /// Enough for every product of `order` corrections of a force of this degree.
    fn for_degree(degree: usize, order: usize) -> Self {
        let highest = 1 + order * degree.saturating_sub(1).max(1);
        let points = highest + degree + 4;
        let cosine = |j: usize| (PI * j as f64 / (2 * points) as f64).cos();
        Self { points, highest, cosines: (0..4 * points).map(cosine).collect() }
    }

    fn at(&self, k: usize, i: usize) -> f64 {
        self.cosines[k * (2 * i + 1) % (4 * self.points)]
    }

    fn cosine(&self, k: usize) -> Vec<f64> {
        (0..self.points).map(|i| self.at(k, i)).collect()
    }

    fn coefficient(&self, values: &[f64], k: usize) -> f64 {
        let sum: f64 = values.iter().enumerate().map(|(i, value)| self.at(k, i) * value).sum();
        if k == 0 { sum / self.points as f64 } else { 2.0 * sum / self.points as f64 }
    }

    fn add(&self, values: &mut [f64], factor: f64, k: usize) {
        for (i, value) in values.iter_mut().enumerate() {
            *value += factor * self.at(k, i);
        }
    }

    fn second_derivative(&self, values: &[f64]) -> Vec<f64> {
        let mut result = vec![0.0; self.points];
        for k in 1..=self.highest {
            self.add(&mut result, -((k * k) as f64) * self.coefficient(values, k), k);
        }
        result
    }

    /// The solution of `y'' + y = factor * right` without its cosine, zero at `theta = 0`.
    fn inverse(&self, right: &[f64], factor: f64) -> Vec<f64> {
        let mut result = vec![0.0; self.points];
        let mut start = 0.0;
        for k in (0..=self.highest).filter(|&k| k != 1) {
            let part = factor * self.coefficient(right, k) / (1.0 - (k * k) as f64);
            self.add(&mut result, part, k);
            start += part;
        }
        self.add(&mut result, -start, 1);
        result
    }
}

/// The coefficients of `q^0 ... q^(count-1)` of `sum_k g_k (sum_j q^j x_j)^k`, point by point.
fn powers_of_series(motions: &[Vec<f64>], count: usize, g: &[f64]) -> Vec<Vec<f64>> {
    let points = motions[0].len();
    let mut result = vec![vec![0.0; points]; count];
    for i in 0..points {
        let series: Vec<f64> =
            (0..count).map(|j| motions.get(j).map_or(0.0, |motion| motion[i])).collect();
        let mut power = series.clone();
        for (k, factor) in g.iter().enumerate().skip(1) {
            if k > 1 {
                power = series_product(&power, &series);
            }
            for (row, value) in result.iter_mut().zip(&power) {
                row[i] += factor * value;
            }
        }
    }
    result
}

/// `a_1 + ... + a_n` of the homotopy `omega^2 (x_n'' + x_n) = - sum a_i x_(n-i) - N_(n-1)`.
fn homotopy_corrections(wave: &Waves, force: &[f64], omega: f64, order: usize) -> f64 {
    let mut motions = vec![wave.cosine(1)];
    let mut corrections: Vec<f64> = Vec::new();
    for n in 1..=order {
        let mut right = powers_of_series(&motions, n, force)[n - 1].clone();
        for (i, correction) in corrections.iter().enumerate() {
            for (value, term) in right.iter_mut().zip(&motions[n - 1 - i]) {
                *value += correction * term;
            }
        }
        corrections.push(-wave.coefficient(&right, 1));
        if n < order {
            motions.push(wave.inverse(&right, -1.0 / omega));
        }
    }
    corrections.iter().sum()
}

/// The root of `relation(part, omega)` at `part = 1` on the branch with `omega = 1` at `part = 0`;
/// `None` where it folds back.
fn follow(relation: &dyn Fn(f64, f64) -> f64, g: &[f64]) -> Option<f64> {
    let strength = (2..g.len())
        .map(|k| (g[k] / g[1]).abs().powf(1.0 / (k - 1) as f64))
        .fold(0.0, f64::max)
        .max(f64::MIN_POSITIVE);
    let newton = |part: f64, start: f64| -> Option<f64> {
        let mut omega = start;
        for _ in 0..12 {
            let h = 1e-6 * omega;
            let slope = (relation(part, omega + h) - relation(part, omega - h)) / (2.0 * h);
            let change = relation(part, omega) / slope;
            omega -= change;
            if omega <= 0.0 || !omega.is_finite() || !change.is_finite() {
                return None;
            }
            if change.abs() < 1e-10 * omega {
                // Once more with the slope as it is: to the last digits.
                return Some(omega - relation(part, omega) / slope);
            }
        }
        None
    };
    let mut part = (1e-4 / strength).min(1.0);
    let mut current = newton(part, 1.0)?;
    let (mut before, mut step) = ((part, current), 0.1_f64);
    while part < 1.0 {
        let next = f64::min(part * step.exp(), 1.0);
        let along = if before.0 < part { (next / part).ln() / (part / before.0).ln() } else { 0.0 };
        let start = current * (current / before.1).powf(along);
        match newton(next, start).filter(|found| (found / start).ln().abs() < 0.01) {
            Some(found) => {
                before = (part, current);
                (part, current) = (next, found);
                step = f64::min(1.6 * step, 1.0);
            }
            None => step *= 0.5,
        }
        if step < 1e-8 {
            return None;
        }
    }
    Some(current)
}

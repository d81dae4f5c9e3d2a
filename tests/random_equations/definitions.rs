//! Each method from its definition in the literature, by quadrature, recursion in numbers and continuation: omega^2 at one
//! amplitude, without dimensions. The references are those at the head of the method's file in `src/method/`.

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};

use crate::force::{Force, Shape, Term};
use crate::quadrature::{Integrals, bisect, integrate, solve};

/// What a definition gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// omega^2, and how far rounding in a fair evaluation may move it, relatively.
    Value(f64, f64),
    /// The same for a motion about another equilibrium, on which a method may be silent.
    Elsewhere(f64, f64),
    /// The definition has no value here: a motion through a pole, a fold of the branch, no limit at rest.
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
    fn f(&self, y: f64) -> f64 {
        self.force.rise(self.origin, y)
    }

    fn size(&self) -> f64 {
        self.amplitude.abs()
    }

    /// Whether the force is finite on the whole way of a motion of one term.
    fn reachable(&self) -> bool {
        let (low, high) = self.force.domain(self.origin);
        self.origin - self.size() > low && self.origin + self.size() < high
    }

    /// What rounding does to the force at this distance, relatively: of its terms, and of the equilibrium itself.
    fn noise(&self, y: f64) -> f64 {
        let x = self.origin + y;
        let moved = if self.origin == 0.0 {
            0.0
        } else {
            self.origin.abs() * self.force.slope(x).abs()
        };
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

    fn given(&self, squared: f64, noise: f64) -> Answer {
        if squared.is_finite() && noise.is_finite() {
            Answer::Value(squared, ROUNDING * (10.0 + noise))
        } else {
            Answer::Nothing("the force overflows")
        }
    }

    /// Angles at which a motion of one term passes the places where the force turns fast.
    fn angles(&self) -> Vec<f64> {
        let mut angles = vec![0.0, 0.25 * PI, FRAC_PI_2, 0.75 * PI, PI];
        let cosines = self
            .force
            .places()
            .into_iter()
            .map(|place| (place - self.origin) / self.size());
        angles.extend(cosines.filter(|cosine| cosine.abs() < 1.0).map(f64::acos));
        angles.sort_by(f64::total_cmp);
        angles
    }

    /// `c_1/A = (2/(pi A)) int_0^pi f(A cos theta) cos theta dtheta`: iteration perturbation, parameter expansion, max-min,
    /// Hamiltonian and variational iteration.
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
        let terms = integrate(&|y| self.force.size(self.origin + y), &places, 1e-4).unwrap_or(f64::INFINITY);
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
        let near = [0.5 - 1e-6, 0.5 + 1e-6].map(|part| self.force.slope(self.origin + part * self.size()));
        if near.iter().any(|value| (value - slope).abs() > 1e-2 * slope.abs()) {
            return Answer::Unknown;
        }
        // The slope is a difference of slopes of the terms.
        let terms: f64 = self
            .force
            .terms
            .iter()
            .map(|term| {
                let alone = Force {
                    terms: vec![*term],
                    ..self.force.clone()
                };
                alone.slope(self.origin + 0.5 * self.size()).abs()
            })
            .sum();
        self.given(slope, 1e2 * terms / slope.abs())
    }

    /// The Taylor coefficients of the force in units of the amplitude: `g_k = f_k A^(k-1)`, from the linear one on.
    fn scaled_taylor(&self, degree: usize) -> Option<Vec<f64>> {
        let series = self.force.taylor(self.origin, degree)?;
        let scaled: Vec<f64> = (0..=degree)
            .map(|k| {
                if k == 0 {
                    0.0
                } else {
                    series[k] * self.amplitude.powi(k as i32 - 1)
                }
            })
            .collect();
        scaled.iter().all(|value| value.is_finite()).then_some(scaled)
    }

    /// `omega^2 = sum e_k A^k`: each `e_k A^k`, through the period as a function of the energy.
    ///
    /// With `V = u^2/2` and `y = sum b_k u^k` the period is `2 pi sum (2j+1) b_(2j+1) (2j-1)!!/(2j)!! (2V)^j`: the integral of
    /// `dy/du` over a circle of radius `sqrt(2V)`.
    pub fn exact_series(&self, order: usize) -> Option<Vec<f64>> {
        let g = self.scaled_taylor(order + 1)?;
        if g[1] <= 0.0 {
            return None;
        }
        // 2V/(g_1 z^2) = 1 + ..., and u/z = its root.
        let square: Vec<f64> = (0..=order).map(|k| 2.0 * g[k + 1] / ((k + 2) as f64 * g[1])).collect();
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

    /// The quotient of polynomials that agrees with the exact series, in the squared amplitude where odd powers are absent.
    /// In a parameter, `step` is the power of the amplitude that goes with it.
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
            if k < 0 {
                0.0
            } else {
                c[k as usize] / growth.powi(k as i32)
            }
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
            let terms: Vec<f64> = terms
                .iter()
                .enumerate()
                .map(|(k, t)| t * growth.powi(k as i32))
                .collect();
            (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum())
        };
        let (numerator, denominator) = (sum(&p), sum(&q));
        let noise = numerator.1 / numerator.0.abs() + denominator.1 / denominator.0.abs();
        // Coefficients of a nearly singular system are rounding: what a change of the last digits does is part of the noise.
        self.given(numerator.0 / denominator.0, 1e4 * noise)
    }

    pub fn is_odd(&self) -> bool {
        self.origin == 0.0 && self.force.is_odd()
    }

    /// `1 = Om + a_1 + ... + a_n` in units of the linear force: the root that continues it from rest.
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
                .map(|k| {
                    if k < 2 {
                        0.0
                    } else {
                        g[k] / g[1] * part.powi(k as i32 - 1)
                    }
                })
                .collect();
            omega + homotopy_corrections(&wave, &force, omega, order) - 1.0
        };
        // At first order the relation is linear in omega^2.
        let root = if order == 1 {
            Some(1.0 - relation(1.0, 1.0))
        } else {
            follow(&relation, &g)
        };
        match root {
            Some(omega) => self.given(g[1] * omega, 1e3),
            None => Answer::Nothing("the branch from the linear frequency ends before this amplitude"),
        }
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
        for m in 1..=order {
            // R_m without the frequency that it fixes.
            let forces = powers_of_series(&motions, m, &g);
            let mut right = forces[m - 1].clone();
            let accelerations: Vec<Vec<f64>> = motions.iter().map(|motion| wave.second_derivative(motion)).collect();
            let squared = |k: usize| -> f64 {
                (0..=k)
                    .map(|i| frequencies.get(i).unwrap_or(&0.0) * frequencies.get(k - i).unwrap_or(&0.0))
                    .sum()
            };
            for (j, acceleration) in accelerations.iter().enumerate().take(m) {
                let factor = squared(m - 1 - j);
                for (value, term) in right.iter_mut().zip(acceleration) {
                    *value += factor * term;
                }
            }
            let secular = wave.coefficient(&right, 1);
            if m == 1 {
                if secular <= 0.0 || secular.is_nan() {
                    return Answer::Value(scale * secular, 1e-9);
                }
                frequencies.push(secular.sqrt());
            } else {
                frequencies.push(secular / (2.0 * frequencies[0]));
            }
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
        self.given(scale * omega * omega, 1e3 * terms / omega)
    }

    /// The second pass of iteration perturbation: no secular term in `Om x_1 - f(x_1)`, on the branch from rest.
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
                if k < 2 {
                    g[k] / g[1]
                } else {
                    g[k] / g[1] * part.powi(k as i32 - 1)
                }
            };
            let force = |x: &[f64]| -> Vec<f64> {
                x.iter()
                    .map(|&x| (1..=degree).rev().fold(0.0, |sum, k| (sum + coefficient(k)) * x))
                    .collect()
            };
            let first = force(&start);
            // x_1 = cos + sum_(k != 1) c_k (cos k - cos)/((k^2 - 1) omega^2)
            let mut motion = wave.inverse(&first, 1.0 / omega);
            motion
                .iter_mut()
                .zip(&start)
                .for_each(|(value, cosine)| *value = cosine - *value);
            let second = force(&motion);
            omega * wave.coefficient(&motion, 1) - wave.coefficient(&second, 1)
        };
        match follow(&relation, &g) {
            Some(omega) => self.given(g[1] * omega, 1e3),
            None => Answer::Nothing("the branch from the linear frequency ends before this amplitude"),
        }
    }

    /// How many waves of sines and exponents of exponentials the motion runs through: beyond a few, sums over points say
    /// nothing of them.
    fn waves(&self) -> f64 {
        let rate = |term: &Term| match term.shape {
            Shape::Sine(b) | Shape::Cosine(b) | Shape::Exponential(b) | Shape::Sinh(b) => b.value() * self.size(),
            _ => 0.0,
        };
        self.force.terms.iter().map(rate).fold(0.0, f64::max)
    }

    /// Harmonics balanced by Newton's iteration, followed in the amplitude from rest.
    pub fn harmonic_balance(&self, order: usize) -> Answer {
        if self.force.has_corners() || self.waves() > 20.0 {
            return Answer::Unknown;
        }
        let harmonics: Vec<usize> = if self.is_odd() {
            (0..order).map(|k| 2 * k + 1).collect()
        } else {
            (0..=order).collect()
        };
        let mut points = 16 * harmonics.last().expect("a harmonic") + 48;
        if let Some(degree) = self.force.degree() {
            points = (degree + 1) * (harmonics.last().expect("a harmonic") + 1) + 4;
        }
        // Once on a branch, more points only move the answer a little.
        let mut current = None;
        loop {
            let Some(found) = self.balance(&harmonics, points, current.as_deref()) else {
                return match current {
                    None => Answer::Nothing("the balance has no branch from rest to this amplitude"),
                    Some(_) => Answer::Unknown,
                };
            };
            let change = current
                .as_ref()
                .map_or(1.0, |before: &Vec<f64>| (before[0] / found[0] - 1.0).abs());
            if self.force.degree().is_some() || change < 1e-12 {
                return self.given(found[0], 1e4);
            }
            if points > 3000 || (current.is_some() && change > 0.05) {
                return Answer::Unknown;
            }
            current = Some(found);
            points *= 2;
        }
    }

    /// omega^2 and the coefficients in units of the amplitude: from rest, or from a solution with fewer points.
    fn balance(&self, harmonics: &[usize], points: usize, near: Option<&[f64]>) -> Option<Vec<f64>> {
        let count = harmonics.len();
        let first = harmonics.iter().position(|&k| k == 1).expect("the first harmonic");
        let table: Vec<Vec<f64>> = (0..points)
            .map(|i| {
                let theta = PI * (i as f64 + 0.5) / points as f64;
                harmonics.iter().map(|&k| (k as f64 * theta).cos()).collect()
            })
            .collect();
        // Unknowns in units of the amplitude `part A`: omega^2, a_k.
        let newton = |part: f64, start: &[f64]| -> Option<Vec<f64>> {
            let amplitude = part * self.amplitude;
            let mut unknowns = start.to_vec();
            let mut last = 1.0;
            for _ in 0..12 {
                let mut rows = vec![vec![0.0; count + 2]; count + 1];
                for cosines in &table {
                    let y: f64 = cosines.iter().zip(&unknowns[1..]).map(|(c, a)| c * a).sum();
                    let force = self.f(amplitude * y) / amplitude;
                    let slope = self.force.slope(self.origin + amplitude * y);
                    for (row, cosine) in cosines.iter().enumerate() {
                        let weight = if harmonics[row] == 0 { 1.0 } else { 2.0 } / points as f64 * cosine;
                        rows[row][count + 1] -= weight * force;
                        for (column, other) in cosines.iter().enumerate() {
                            rows[row][column + 1] += weight * slope * other;
                        }
                    }
                }
                for (row, &k) in harmonics.iter().enumerate() {
                    let inertia = (k * k) as f64;
                    rows[row][count + 1] += inertia * unknowns[0] * unknowns[row + 1];
                    rows[row][0] = -inertia * unknowns[row + 1];
                    rows[row][row + 1] -= inertia * unknowns[0];
                    rows[count][row + 1] = 1.0;
                }
                rows[count][count + 1] = 1.0 - unknowns[1..].iter().sum::<f64>();
                if rows.iter().flatten().any(|value| !value.is_finite()) {
                    return None;
                }
                // omega^2 in its own unit.
                let unit = unknowns[0].abs();
                for row in &mut rows {
                    row[0] *= unit;
                }
                for row in &mut rows[..count] {
                    row.iter_mut().for_each(|value| *value /= unit);
                }
                let change = solve(rows)?;
                unknowns[0] += unit * change[0];
                (1..=count).for_each(|i| unknowns[i] += change[i]);
                let moved = change.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
                if !moved.is_finite() || unknowns[0] <= 0.0 {
                    return None;
                }
                // To the last digits, or to where rounding stops them.
                if moved < 1e-12 || (moved < 1e-9 && last < 1e-9) {
                    return Some(unknowns);
                }
                last = moved;
            }
            None
        };
        if let Some(near) = near {
            return newton(1.0, near);
        }
        let mut part = self.gentle_part();
        let mut current = vec![0.0; count + 1];
        current[0] = match (Question {
            amplitude: part * self.amplitude,
            ..*self
        })
        .shared_integral()
        {
            Answer::Value(squared, _) if squared > 0.0 => squared,
            _ => return None,
        };
        current[first + 1] = 1.0;
        current = newton(part, &current)?;
        let (mut before, mut step) = ((part, current.clone()), 0.05_f64);
        while part < 1.0 {
            let next = f64::min(part * step.exp(), 1.0);
            // Straight on in the logarithms of amplitude and frequency.
            let mut start = current.clone();
            if before.0 < part {
                let along = (next / part).ln() / (part / before.0).ln();
                start[0] = current[0] * (current[0] / before.1[0]).powf(along);
                (1..=count).for_each(|i| start[i] += along * (current[i] - before.1[i]));
            }
            let near = |found: &Vec<f64>| {
                (found[0] / start[0]).ln().abs() < 0.02
                    && (1..=count).all(|i| (found[i] - start[i]).abs() < 0.02)
                    && found[first + 1].abs() > 1e-3
            };
            match newton(next, &start).filter(near) {
                Some(found) => {
                    before = (part, current);
                    (current, part) = (found, next);
                    step = f64::min(1.5 * step, 0.4);
                }
                None => step *= 0.5,
            }
            if step < 1e-7 {
                return None;
            }
        }
        Some(current)
    }

    /// A part of the amplitude at which the force is linear, or a power, to a few digits.
    fn gentle_part(&self) -> f64 {
        let mut part = 1.0_f64;
        for _ in 0..200 {
            let power = |y: f64| (self.f(2.0 * y) / self.f(y)).abs().log2();
            let y = part * self.amplitude;
            let powers = [
                power(y / 16.0),
                power(y / 4.0),
                power(y / 2.0),
                power(-y / 16.0),
                power(-y / 2.0),
            ];
            let whole = powers[0].round();
            if powers.iter().all(|value| (value - whole).abs() < 2e-3) {
                return part;
            }
            part *= 0.5;
        }
        part
    }

    /// The true frequency, squared: twice the time between the turning points, by the energy integral.
    pub fn truth(&self) -> Answer {
        let start = self.amplitude;
        let Some(end) = self.far_turning_point() else {
            return Answer::Nothing("the motion does not come back");
        };
        let (left, right) = (start.min(end), start.max(end));
        let force = |y: f64| self.f(y);
        let Some(work) = Integrals::new(&force, &self.stops(left, right)) else {
            return Answer::Unknown;
        };
        let (middle, radius) = (0.5 * (left + right), 0.5 * (right - left));
        // y = m + r sin(phi): dt = dphi/sqrt(2 g), U = (right - y)(y - left) g.
        let time = |phi: f64| {
            let y = middle + radius * phi.sin();
            let near = 2.0 * (0.25 * PI - 0.5 * phi).sin().powi(2);
            let far = 2.0 * (0.25 * PI + 0.5 * phi).sin().powi(2);
            let rise = if phi >= 0.0 { work.beyond(y) } else { -work.up_to(y) };
            (near * far * radius * radius / (2.0 * rise)).sqrt()
        };
        let mut angles: Vec<f64> = vec![-FRAC_PI_2, -0.8, 0.0, 0.8, FRAC_PI_2];
        let sines = self
            .stops(left, right)
            .into_iter()
            .map(|place| (place - middle) / radius);
        angles.extend(sines.filter(|sine| sine.abs() < 1.0).map(f64::asin));
        angles.sort_by(f64::total_cmp);
        match integrate(&time, &angles, 1e-12) {
            Some(half) => {
                let omega = TAU / (2.0 * half);
                let rounding =
                    self.noise(start).max(self.noise(end)) + start.abs().max(end.abs()) / (start - end).abs();
                match self.given(omega * omega, 1e4 + 10.0 * rounding) {
                    Answer::Value(squared, noise) if start * self.f(start) < 0.0 => Answer::Elsewhere(squared, noise),
                    answer => answer,
                }
            }
            None => Answer::Unknown,
        }
    }

    /// The ends of an interval and the places between them where the force turns fast.
    fn stops(&self, left: f64, right: f64) -> Vec<f64> {
        let mut stops = vec![left, right];
        let places = self
            .force
            .places()
            .into_iter()
            .map(|place| place - self.origin)
            .chain([0.0]);
        stops.extend(places.filter(|place| *place > left && *place < right));
        stops.sort_by(f64::total_cmp);
        stops
    }

    /// Where the motion turns back; `None` where it leaves.
    pub fn far_turning_point(&self) -> Option<f64> {
        let start = self.amplitude;
        let (low, high) = self.force.domain(self.origin);
        if self.origin + start <= low || self.origin + start >= high || self.f(start) == 0.0 {
            return None;
        }
        // The side it comes from.
        let side = self.f(start).signum();
        let force = |y: f64| self.f(y);
        if self.is_odd() && side == start.signum() {
            // By symmetry, if nothing is in the way: the energy stays positive in between.
            let size = self.size();
            let work = Integrals::new(&force, &self.stops(0.0, size))?;
            let mut places: Vec<f64> = (0..1000).map(|k| size * f64::from(k) / 1000.0).collect();
            places.extend(self.stops(0.0, size).into_iter().filter(|place| *place < size));
            return places.iter().all(|y| work.beyond(*y) > 0.0).then_some(-start);
        }
        let work = |from: f64, to: f64| -> f64 {
            let stops = self.stops(from.min(to), from.max(to));
            integrate(&force, &stops, 1e-15).map_or(f64::NAN, |value| value * (to - from).signum())
        };
        let places = self
            .force
            .places()
            .into_iter()
            .map(|place| place - self.origin)
            .chain([0.0]);
        // In steps that grow with the distance travelled, no larger than the features.
        let end = if side > 0.0 { low } else { high } - self.origin;
        let (mut y, mut left) = (start, 0.0);
        let mut stops: Vec<f64> = places.filter(|place| side * place < side * start).collect();
        stops.sort_by(|a, b| (side * b).total_cmp(&(side * a)));
        let mut travelled = 0.0;
        for _ in 0..6000 {
            let step = (0.01 * start.abs()).max(0.01 * travelled);
            let mut next = y - side * step;
            if let Some(stop) = stops.iter().find(|stop| side * **stop < side * y - 1e-12 * start.abs())
                && side * next < side * stop
            {
                next = *stop;
            }
            if end.is_finite() && side * next <= side * end {
                next = 0.5 * (y + end);
            }
            let after = left + work(next, y);
            if !after.is_finite() {
                return None;
            }
            if after <= 0.0 {
                return Some(bisect(&|z| left + work(z, y), next, y));
            }
            travelled += (y - next).abs();
            (y, left) = (next, after);
            if travelled > 1e9 * start.abs() {
                return None;
            }
        }
        None
    }
}

fn series_product(a: &[f64], b: &[f64]) -> Vec<f64> {
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
        Self {
            points,
            highest,
            cosines: (0..4 * points).map(cosine).collect(),
        }
    }

    fn at(&self, k: usize, i: usize) -> f64 {
        self.cosines[k * (2 * i + 1) % (4 * self.points)]
    }

    fn cosine(&self, k: usize) -> Vec<f64> {
        (0..self.points).map(|i| self.at(k, i)).collect()
    }

    fn coefficient(&self, values: &[f64], k: usize) -> f64 {
        let sum: f64 = values.iter().enumerate().map(|(i, value)| self.at(k, i) * value).sum();
        if k == 0 {
            sum / self.points as f64
        } else {
            2.0 * sum / self.points as f64
        }
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
        let series: Vec<f64> = (0..count)
            .map(|j| motions.get(j).map_or(0.0, |motion| motion[i]))
            .collect();
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

/// The root of `relation(part, omega)` at `part = 1` on the branch with `omega = 1` at `part = 0`; `None` where it folds back.
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
        let along = if before.0 < part {
            (next / part).ln() / (part / before.0).ln()
        } else {
            0.0
        };
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

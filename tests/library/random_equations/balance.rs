//! Harmonic balance by Newton's iteration, followed in the amplitude from rest.

use std::f64::consts::PI;

use super::definitions::{Answer, Question};
use super::force::{Shape, Term};
use super::quadrature::{bisect, integrate, solve};

impl Question<'_> {
    /// How many waves of sines and exponents of exponentials the motion runs through: beyond a few,
    /// sums over points say nothing of them.
    pub fn waves(&self) -> f64 {
        let rate = |term: &Term| match term.shape {
            Shape::Sine(b) | Shape::Cosine(b) | Shape::Exponential(b) | Shape::Sinh(b) => {
                b.value() * self.size()
            }
            _ => 0.0,
        };
        self.force.terms.iter().map(rate).fold(0.0, f64::max)
    }

    /// Harmonics balanced by Newton's iteration, followed in the amplitude from rest.
    pub fn harmonic_balance(&self, order: usize) -> Answer {
        if self.force.has_corners() || self.waves() > 20.0 {
            return Answer::Unknown;
        }
        if order == 1 && self.is_odd() {
            return self.shared_integral();
        }
        // Past another equilibrium the branch from rest may turn back, and what the steps below
        // jump onto is another one.
        if self.meets_equilibria() {
            return Answer::Unknown;
        }
        let harmonics = self.balanced(order);
        let mut points = 16 * harmonics.last().expect("a harmonic") + 48;
        if let Some(degree) = self.force.degree() {
            points = (degree + 1) * (harmonics.last().expect("a harmonic") + 1) + 4;
        }
        // Once on a branch, more points only move the answer a little; a branch that ends may be
        // the fault of too few.
        let polynomial = self.force.degree().is_some();
        let mut current = None;
        loop {
            let Some(found) = self.balance(&harmonics, points, current.as_deref()) else {
                if current.is_some() || points > 3000 {
                    return Answer::Unknown;
                }
                if polynomial {
                    return Answer::Nothing(
                        "the balance has no branch from rest to this amplitude",
                    );
                }
                points *= 4;
                continue;
            };
            let change = current
                .as_ref()
                .map_or(1.0, |before: &Vec<f64>| (before[0] / found[0] - 1.0).abs());
            if polynomial {
                return self.given(found[0], 1e4);
            }
            if change < 1e-12 {
                // Even points may miss a narrow place of the force, however many agree: the defect
                // is measured beside this.
                let narrow = !self.force.places().is_empty();
                return self.given(found[0], if narrow { 1e8 } else { 1e4 });
            }
            if points > 3000 || (current.is_some() && change > 0.05) {
                return Answer::Unknown;
            }
            current = Some(found);
            points *= 2;
        }
    }

    /// The harmonics that are balanced.
    pub fn balanced(&self, order: usize) -> Vec<usize> {
        if self.is_odd() { (0..order).map(|k| 2 * k + 1).collect() } else { (0..=order).collect() }
    }

    /// Whether the force vanishes between rest and half as much again as the amplitude, on either
    /// side.
    fn meets_equilibria(&self) -> bool {
        const SAMPLES: u32 = 2000;
        let even = (1..=SAMPLES).map(|k| 1.5 * self.size() * f64::from(k) / f64::from(SAMPLES));
        // Wells may be far smaller than the motion.
        let even =
            even.chain((0..4 * SAMPLES).map(|k| 1.5 * self.size() * (-f64::from(k) / 200.0).exp()));
        let places = self.force.places().into_iter().map(|place| (place - self.origin).abs());
        let mut sizes = even.chain(places.filter(|size| *size > 0.0 && *size < 1.5 * self.size()));
        sizes.any(|y| self.f(y) <= 0.0 || self.f(-y) >= 0.0)
    }

    /// How far a motion of these coefficients is from a balance of its harmonics, beside the
    /// inertia of a motion of one term; less what the last digits of the coefficients may do to it.
    /// `None` where the integrals do not settle.
    pub fn defect_of_balance(
        &self,
        squared: f64,
        coefficients: &[f64],
        order: usize,
    ) -> Option<f64> {
        const PANELS: i32 = 64;
        let mut panels: Vec<f64> =
            (0..=PANELS).map(|k| PI * f64::from(k) / f64::from(PANELS)).collect();
        let distance = |theta: f64| -> f64 {
            let wave = |(k, a): (usize, &f64)| a * (k as f64 * theta).cos();
            coefficients.iter().enumerate().map(wave).sum()
        };
        // Where the motion passes the places at which the force turns fast.
        for place in self.force.places() {
            let excess = |theta: f64| distance(theta) - (place - self.origin);
            let crossed: Vec<f64> = panels
                .windows(2)
                .filter(|pair| excess(pair[0]) * excess(pair[1]) < 0.0)
                .map(|pair| bisect(&excess, pair[0], pair[1]))
                .collect();
            panels.extend(crossed);
            panels.sort_by(f64::total_cmp);
        }
        // The last digit of the coefficients moves the motion, beside a pole by more than its
        // distance allows.
        let rounding = f64::EPSILON * coefficients.iter().map(|a| a.abs()).sum::<f64>();
        let slope = |theta: f64| self.force.slope(self.origin + distance(theta)).abs();
        let noise =
            2.0 / PI * rounding * integrate(&slope, &panels, 1e-3)? / (squared * self.size());
        let mut largest = (coefficients.iter().sum::<f64>() / self.amplitude - 1.0).abs();
        for k in self.balanced(order) {
            let integrand = |theta: f64| self.f(distance(theta)) * (k as f64 * theta).cos();
            let force = 2.0 / PI * integrate(&integrand, &panels, 1e-10)?;
            let inertia = (k * k) as f64 * squared * coefficients.get(k).copied().unwrap_or(0.0);
            largest = largest.max((force - inertia).abs() / (squared * self.size()));
        }
        Some(f64::max(largest - noise, 0.0))
    }

    /// omega^2 and the coefficients in units of the amplitude: from rest, or from a solution with
    /// fewer points.
    fn balance(
        &self,
        harmonics: &[usize],
        points: usize,
        near: Option<&[f64]>,
    ) -> Option<Vec<f64>> {
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
                        let weight =
                            if harmonics[row] == 0 { 1.0 } else { 2.0 } / points as f64 * cosine;
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
        current[0] =
            match (Question { amplitude: part * self.amplitude, ..*self }).shared_integral() {
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
}

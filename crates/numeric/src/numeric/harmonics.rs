//! The harmonics of a periodic function from its values at equal steps of a period, and back, by
//! the fast Fourier transform.
//!
//! ```text
//! a_k = 2/N sum_j f_j cos(k theta_j),   b_k = 2/N sum_j f_j sin(k theta_j),   theta_j = 2 pi j/N
//! ```
//!
//! A transform of N samples costs N log N products, whatever the number of harmonics.

use std::sync::Arc;

use num_complex::Complex;
use rustfft::{Fft, FftPlanner};

/// The Fourier coefficients of the harmonics from 0 to some highest one.
pub struct Harmonics {
    /// Twice the mean, then the coefficient of `cos(k theta)` at `k`.
    pub cosines: Vec<f64>,
    /// Zero, then the coefficient of `sin(k theta)` at `k`.
    pub sines: Vec<f64>,
}

impl Harmonics {
    /// Adds a function concentrated at one phase, where its integral over the phase is `value`.
    pub fn add(&mut self, phase: f64, value: f64) {
        if value == 0.0 {
            return;
        }
        let value = value / std::f64::consts::PI;
        let (step_sine, step_cosine) = phase.sin_cos();
        let (mut cosine, mut sine) = (1.0, 0.0);
        for (cosines, sines) in self.cosines.iter_mut().zip(&mut self.sines) {
            *cosines += value * cosine;
            *sines += value * sine;
            (cosine, sine) =
                (cosine * step_cosine - sine * step_sine, sine * step_cosine + cosine * step_sine);
        }
    }

    /// Returns the coefficient of the cosine for an index of either sign.
    pub fn cosine(&self, index: isize) -> f64 {
        self.cosines[index.unsigned_abs()]
    }

    /// Returns the coefficient of the sine for an index of either sign, odd in the index.
    pub fn sine(&self, index: isize) -> f64 {
        let value = self.sines[index.unsigned_abs()];
        if index < 0 { -value } else { value }
    }
}

/// The discrete Fourier transform of a fixed number of samples.
#[derive(Clone)]
pub struct Transform {
    whole: Arc<dyn Fft<f64>>,
    half: Option<HalfTransform>,
}

/// The transform of half of an even number of samples.
#[derive(Clone)]
struct HalfTransform {
    transform: Arc<dyn Fft<f64>>,
    /// `e^(-i theta_k)` for each of them, theta_k being that of all samples.
    turns: Arc<[Complex<f64>]>,
}

impl std::fmt::Debug for Transform {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_tuple("Transform").field(&self.samples()).finish()
    }
}

impl Transform {
    /// The transform of this many samples per period.
    pub fn new(samples: usize) -> Self {
        let mut planner = FftPlanner::new();
        let half = samples / 2;
        let turns =
            || (0..half).map(|k| Complex::cis(-std::f64::consts::TAU * k as f64 / samples as f64));
        let is_even = samples.is_multiple_of(2) && half > 0;
        Self {
            whole: planner.plan_fft_forward(samples),
            half: is_even.then(|| HalfTransform {
                transform: planner.plan_fft_forward(half),
                turns: turns().collect(),
            }),
        }
    }

    /// The number of samples.
    pub fn samples(&self) -> usize {
        self.whole.len()
    }

    /// The harmonics of samples, up to `count`, which is at most half the number of samples.
    pub fn harmonics(&self, values: &[f64], count: usize) -> Harmonics {
        if let [first, rest @ ..] = values
            && rest.iter().all(|value| value == first)
        {
            let mut cosines = vec![0.0; count + 1];
            cosines[0] = 2.0 * first;
            return Harmonics { cosines, sines: vec![0.0; count + 1] };
        }
        let parts = self.spectrum(values, count);
        let factor = 2.0 / values.len() as f64;
        Harmonics {
            cosines: parts.iter().map(|part| factor * part.re).collect(),
            sines: parts.iter().map(|part| -factor * part.im).collect(),
        }
    }

    /// The sums `sum_j f_j e^(-i k theta_j)` for k up to `count`, at most half the number of samples.
    /// An even number of real samples is half as many complex ones: with z_j = f_2j + i f_(2j+1) the
    /// sum is `Z_k + Z*_(-k)` over the even samples and, turned by theta_k, `-i (Z_k - Z*_(-k))` over
    /// the odd ones, each by two.
    fn spectrum(&self, values: &[f64], count: usize) -> Vec<Complex<f64>> {
        let Some(HalfTransform { transform, turns }) = &self.half else {
            let mut parts: Vec<Complex<f64>> =
                values.iter().map(|value| Complex::from(*value)).collect();
            self.whole.process(&mut parts);
            parts.truncate(count + 1);
            return parts;
        };
        let pairs = values.chunks_exact(2);
        let mut parts: Vec<Complex<f64>> =
            pairs.map(|pair| Complex::new(pair[0], pair[1])).collect();
        transform.process(&mut parts);
        let n = parts.len();
        let part = |k: usize| {
            let (here, mirrored) = (parts[k % n], parts[(n - k % n) % n].conj());
            let turn = if k < n { turns[k] } else { -turns[k - n] };
            let odd = here - mirrored;
            0.5 * (here + mirrored + turn * Complex::new(odd.im, -odd.re))
        };
        (0..=count).map(part).collect()
    }

    /// Returns two sums of waves at the samples, as [`Transform::sum_of_waves`] does each, by one
    /// transform of their complex sum; of less than half as many harmonics as samples.
    pub fn sums_of_waves(
        &self,
        one: impl Iterator<Item = [f64; 2]>,
        other: impl Iterator<Item = [f64; 2]>,
    ) -> Vec<[f64; 2]> {
        let samples = self.samples();
        let mut parts = vec![Complex::from(0.0); samples];
        // a cos + b sin = (a + ib)/2 e^(-i k theta) + (a - ib)/2 e^(i k theta)
        for (harmonic, ([a, b], [c, d])) in one.zip(other).enumerate() {
            parts[harmonic] += 0.5 * Complex::new(a - d, b + c);
            parts[(samples - harmonic) % samples] += 0.5 * Complex::new(a + d, c - b);
        }
        self.whole.process(&mut parts);
        parts.iter().map(|part| [part.re, part.im]).collect()
    }

    /// Returns the sum of waves at the samples, from the coefficients `[cosine, sine]` of the
    /// harmonics from 0 on.
    pub fn sum_of_waves(&self, waves: impl Iterator<Item = [f64; 2]>) -> Vec<f64> {
        let mut parts: Vec<Complex<f64>> =
            waves.map(|[cosine, sine]| Complex::new(cosine, sine)).collect();
        parts.resize(self.samples(), Complex::from(0.0));
        self.whole.process(&mut parts);
        parts.iter().map(|part| part.re).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the sums that define them, of an even number of samples and of an odd one, and there
    /// and back.
    #[test]
    fn harmonics_are_the_sums_that_define_them() {
        for samples in [64, 6, 45] {
            harmonics_of(samples);
        }
    }

    fn harmonics_of(samples: usize) {
        let transform = Transform::new(samples);
        let phase = |sample: usize| std::f64::consts::TAU * sample as f64 / samples as f64;
        let values: Vec<f64> =
            (0..samples).map(|sample| (2.0 * phase(sample).cos()).exp().sin()).collect();
        let found = transform.harmonics(&values, samples / 2);
        for (harmonic, (cosine, sine)) in found.cosines.iter().zip(&found.sines).enumerate() {
            let sum = |wave: fn(f64) -> f64| -> f64 {
                let terms = values.iter().enumerate();
                terms
                    .map(|(sample, value)| value * wave(harmonic as f64 * phase(sample)))
                    .sum::<f64>()
                    / (0.5 * samples as f64)
            };
            assert!((cosine - sum(f64::cos)).abs() < 1e-14);
            assert!((sine - sum(f64::sin)).abs() < 1e-14);
        }
        let waves = [[0.5, 0.0], [1.0, -2.0], [0.25, 3.0]];
        let there = transform.sum_of_waves(waves.into_iter());
        let others = waves.map(|[cosine, sine]| [3.0 * sine, 1.0 - cosine]);
        let apart = transform.sum_of_waves(others.into_iter());
        let both = transform.sums_of_waves(waves.into_iter(), others.into_iter());
        for ((one, other), both) in there.iter().zip(&apart).zip(both) {
            assert!((one - both[0]).abs() < 1e-14 && (other - both[1]).abs() < 1e-14);
        }
        let back = transform.harmonics(&there, 2);
        assert!((back.cosines[0] - 1.0).abs() < 1e-15 && back.sines[0].abs() < 1e-15);
        for (harmonic, [cosine, sine]) in waves.into_iter().enumerate().skip(1) {
            assert!((back.cosines[harmonic] - cosine).abs() < 1e-14);
            assert!((back.sines[harmonic] - sine).abs() < 1e-14);
        }
    }
}

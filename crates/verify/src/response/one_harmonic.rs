//! Guesses of motions of every size: where the balance of a single harmonic has a solution.
//!
//! ```text
//! x = X(theta) + m + a cos(k theta - phi),   m(a, phi): the mean of f is zero
//! (k omega)^2 a = 2 <f cos(k theta - phi)>,   0 = 2 <f sin(k theta - phi)>
//! ```
//!
//! (A. H. Nayfeh and D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, chapter 4.) The first
//! equation says at which amplitudes the harmonic k of the motion is in resonance, the second at
//! which of them the drive makes up for what the damping takes: together they have the large
//! motions that no simulation from rest comes to, isolated ones as well. X is a motion that is
//! known, about which the harmonic k grows: a place of rest, or the motion that is forced about it.
//!
//! In: the equation, X and a value of the parameter. Out: motions from which a balance of all
//! harmonics, or shooting, is to start. Amplitudes and phases are looked at on a grid over four
//! decades, and a guess is a cell in which both equations change their signs: some four thousand
//! evaluations of the force for each harmonic up to the number of drive periods, more for higher ones.

use std::f64::consts::TAU;

use nalgebra::DVector;

use super::balance::DrivenBalance;
use super::driven::Driven;
use crate::expr::SampledFunctions;

/// Number of amplitudes in a decade, and of phases.
const EACH_DECADE: i32 = 8;
const PHASES: usize = 12;

/// Decades of amplitudes below and above the size of the motions that are known.
const BELOW: i32 = 1;
const ABOVE: i32 = 3;

/// Samples in a period of the fastest of the harmonics: the products of a cubic force are exact.
const SAMPLES: usize = 8;

/// A motion X and one of its harmonics.
struct AddedHarmonic<'a> {
    driven: &'a Driven,
    /// The coefficients of X, the harmonic itself left out.
    known: DVector<f64>,
    /// The samples of a period, for each phase of the harmonic.
    samples: Vec<Sample>,
    /// The force without jumps, at all of them.
    force: Option<SampledFunctions<1>>,
    /// k.
    number: usize,
    /// The frequency omega of the motion.
    omega: f64,
    parameter: f64,
}

/// A sample, with position and velocity of X and cosine and sine of the harmonic there,
/// `cos(k theta - phi)` and `sin(k theta - phi)`.
struct Sample {
    theta: f64,
    known: [f64; 2],
    wave: [f64; 2],
}

/// The residuals of the two equations, with the mean that goes with them.
#[derive(Clone, Copy)]
struct Residuals {
    in_phase: f64,
    out_of_phase: f64,
    mean: f64,
}

/// Motions about a known one whose harmonic k balances the forces, as coefficients of `balance`;
/// `size` is that of the motions that are known.
pub(super) fn guesses(
    balance: &DrivenBalance,
    known: &DVector<f64>,
    (parameter, number): (f64, usize),
    size: f64,
) -> Vec<DVector<f64>> {
    if !(size > 0.0 && size.is_finite()) || number > balance.core.harmonics {
        return vec![];
    }
    let harmonic = AddedHarmonic::new(balance, known, parameter, number);
    let amplitude = |step: i32| size * 10_f64.powf(f64::from(step) / f64::from(EACH_DECADE));
    // A row has the phases at one amplitude; the mean goes on from one amplitude to the next.
    let row = |before: &[Option<Residuals>], step: i32| -> Vec<Option<Residuals>> {
        let means = before.iter().map(|before| before.map_or(0.0, |before| before.mean));
        harmonic.residuals(amplitude(step), means.collect())
    };
    let mut found = Vec::new();
    let mut before = row(&[None; PHASES], -BELOW * EACH_DECADE);
    for step in 1 - BELOW * EACH_DECADE..=ABOVE * EACH_DECADE {
        let here = row(&before, step);
        for index in 0..PHASES {
            let next = (index + 1) % PHASES;
            let Some(mean) = root_within([before[index], before[next], here[index], here[next]])
            else {
                continue;
            };
            let middle = (amplitude(step - 1) * amplitude(step)).sqrt();
            found.push(harmonic.with(middle, phase(index) + 0.5 * phase(1), mean));
        }
        before = here;
    }
    found
}

/// A phase of the harmonic.
fn phase(index: usize) -> f64 {
    TAU * index as f64 / PHASES as f64
}

/// The mean in a cell in which both residuals change their signs.
fn root_within(corners: [Option<Residuals>; 4]) -> Option<f64> {
    let [one, two, three, four] = corners;
    let corners = [one?, two?, three?, four?];
    let changes = |residual: fn(&Residuals) -> f64| {
        let above = corners.iter().filter(|corner| residual(corner) > 0.0).count();
        (1..corners.len()).contains(&above)
    };
    let is_root = changes(|corner| corner.in_phase) && changes(|corner| corner.out_of_phase);
    is_root.then(|| corners.iter().map(|corner| corner.mean).sum::<f64>() / corners.len() as f64)
}

impl<'a> AddedHarmonic<'a> {
    fn new(
        balance: &'a DrivenBalance<'a>,
        known: &DVector<f64>,
        parameter: f64,
        number: usize,
    ) -> Self {
        let mut known = known.clone();
        known.rows_mut(2 * number - 1, 2).fill(0.0);
        let count = SAMPLES * number.max(balance.driven.periods);
        let sample = |index: usize| {
            let theta = TAU * (index % count) as f64 / count as f64;
            let (sine, cosine) = (number as f64 * theta - phase(index / count)).sin_cos();
            let known = balance.phase_point_at(&known, parameter, theta);
            Sample { theta, known, wave: [cosine, sine] }
        };
        let samples: Vec<Sample> = (0..PHASES * count).map(sample).collect();
        let thetas: Vec<f64> = samples.iter().map(|sample| sample.theta).collect();
        let force = balance.driven.sampled_force(&thetas);
        let omega = balance.driven.frequency_at(parameter);
        Self { driven: balance.driven, known, samples, force, number, omega, parameter }
    }

    /// X with this harmonic and mean.
    fn with(&self, amplitude: f64, phase: f64, mean: f64) -> DVector<f64> {
        let mut motion = self.known.clone();
        let (sine, cosine) = phase.sin_cos();
        motion[0] += mean;
        motion[2 * self.number - 1] = amplitude * cosine;
        motion[2 * self.number] = amplitude * sine;
        motion
    }

    /// The residuals at an amplitude and every phase, with the means of the force made zero by the
    /// secant method from guesses; `None` where the force has no value.
    fn residuals(&self, amplitude: f64, mut means: Vec<f64>) -> Vec<Option<Residuals>> {
        /// Ratio to the amplitude of a first step of the mean, and the largest number of steps.
        const STEP: f64 = 1e-2;
        const STEPS: usize = 4;
        /// Ratio of the mean of the force to its size below which it is zero.
        const NOTHING: f64 = 1e-3;
        let is_open = |sums: &Sums| sums.mean.abs() > NOTHING * sums.size;
        let mut before = vec![None; means.len()];
        let mut all = self.sums(amplitude, &means);
        for _ in 0..STEPS {
            let open = |index: &usize| all[*index].as_ref().is_some_and(is_open);
            let open: Vec<usize> = (0..means.len()).filter(open).collect();
            for index in &open {
                let (Some(sums), mean) = (&all[*index], &mut means[*index]) else { continue };
                let step = match before[*index] {
                    None => STEP * amplitude,
                    Some((last, force)) => sums.mean * (last - *mean) / (sums.mean - force),
                };
                before[*index] = Some((*mean, sums.mean));
                // A mean that runs away is none.
                *mean += step.clamp(-amplitude, amplitude);
            }
            if open.is_empty() {
                break;
            }
            let mut again = self.sums(amplitude, &means);
            for index in open {
                all[index] = again[index].take();
            }
        }
        let speed = self.number as f64 * self.omega;
        let residuals = |(sums, mean): (Option<Sums>, f64)| {
            let sums = sums?;
            let in_phase = 2.0 * sums.cosine - speed * speed * amplitude;
            Some(Residuals { in_phase, out_of_phase: 2.0 * sums.sine, mean })
        };
        all.into_iter().zip(means).map(residuals).collect()
    }

    /// The means of the force, of its products with cosine and sine, and of its size, at every phase.
    fn sums(&self, amplitude: f64, means: &[f64]) -> Vec<Option<Sums>> {
        let count = self.samples.len() / means.len();
        let speed = self.number as f64 * self.omega;
        let memory = || Vec::with_capacity(self.samples.len());
        let (mut positions, mut velocities) = (memory(), memory());
        for (samples, mean) in self.samples.chunks(count).zip(means) {
            let position = |sample: &Sample| sample.known[0] + mean + amplitude * sample.wave[0];
            let velocity = |sample: &Sample| sample.known[1] - amplitude * speed * sample.wave[1];
            positions.extend(samples.iter().map(position));
            velocities.extend(samples.iter().map(velocity));
        }
        let forces = self.forces(&positions, &velocities);
        let of_phase = |(samples, forces): (&[Sample], &[f64])| {
            let mut sums = Sums::default();
            let part = 1.0 / count as f64;
            for (Sample { wave: [cosine, sine], .. }, force) in samples.iter().zip(forces) {
                let force = part * force;
                sums.mean += force;
                sums.cosine += force * cosine;
                sums.sine += force * sine;
                sums.size += force.abs();
            }
            sums.size.is_finite().then_some(sums)
        };
        self.samples.chunks(count).zip(forces.chunks(count)).map(of_phase).collect()
    }

    /// The force at every sample.
    fn forces(&self, positions: &[f64], velocities: &[f64]) -> Vec<f64> {
        let Some(sampled) = &self.force else {
            let states = self.samples.iter().zip(positions.iter().zip(velocities));
            let force = |(sample, (x, v)): (&Sample, (&f64, &f64))| {
                self.driven.force(&[*x, *v, sample.theta, self.parameter])
            };
            return states.map(force).collect();
        };
        let parameters = vec![self.parameter; positions.len()];
        let mut values = vec![];
        sampled.call(&[(0, positions), (1, velocities), (3, &parameters)], &mut values);
        sampled.column(0, &values).to_vec()
    }
}

/// Means over a period.
#[derive(Clone, Default)]
struct Sums {
    mean: f64,
    cosine: f64,
    sine: f64,
    size: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::{PreparedRequest, ResponseRequest};

    /// The cubic equation of Duffing's oscillator for the squared amplitude,
    /// `((3/4 a^2 + 1 - w^2)^2 + c^2 w^2) a^2 = F^2`, has three roots; beside each there is a guess,
    /// and none elsewhere.
    #[test]
    fn every_amplitude_of_duffing_is_guessed() {
        let (c, drive, w) = (0.047, 0.3, 1.5);
        let equation = "x'' + c*x' + x + x^3 = 0.3*cos(1.5*t)";
        let question = ResponseRequest::new(equation, "c", [0.02, 0.4], "").expect("a request");
        let asked = PreparedRequest::new(&question, question.equations.oscillator().expect("one"))
            .expect("a request");
        let balance = DrivenBalance::new(&asked.driven, 3);
        let still = DVector::zeros(balance.core.size());
        let residual = |a: f64| {
            let bent = 0.75 * a * a + 1.0 - w * w;
            (bent * bent + c * c * w * w) * a * a - drive * drive
        };
        let step = 10_f64.powf(1.0 / f64::from(EACH_DECADE));
        let guesses = guesses(&balance, &still, (c, 1), 0.25);
        let amplitudes = guesses.iter().map(|guess| guess[1].hypot(guess[2]));
        let amplitudes: Vec<f64> = amplitudes.collect();
        // The signs between the roots are known: + beyond, - between.
        let mut roots = Vec::new();
        for pair in [[0.1, 0.5], [0.5, 1.25], [1.25, 2.0]] {
            roots.push(
                crate::numeric::ode::root::find_root(residual, pair[0], pair[1]).expect("a root"),
            );
        }
        for root in &roots {
            let is_near = |a: &f64| (a / root).ln().abs() <= step.ln();
            assert!(amplitudes.iter().any(is_near), "{root} {amplitudes:?}");
        }
        for amplitude in &amplitudes {
            let is_near = |root: &f64| (amplitude / root).ln().abs() <= 2.0 * step.ln();
            assert!(roots.iter().any(is_near), "{amplitude} {roots:?}");
        }
    }

    /// The mean moves with the amplitude: `x^2` pushes the motion aside by half of the squared
    /// amplitude, to first order.
    #[test]
    fn the_mean_goes_with_the_amplitude() {
        let equation = "x'' + x'/50 + x + x^2/10 = F*cos(t)";
        let question = ResponseRequest::new(equation, "F", [0.01, 0.05], "").expect("a request");
        let asked = PreparedRequest::new(&question, question.equations.oscillator().expect("one"))
            .expect("a request");
        let balance = DrivenBalance::new(&asked.driven, 3);
        let still = DVector::zeros(balance.core.size());
        let harmonic = AddedHarmonic::new(&balance, &still, 0.02, 1);
        for found in harmonic.residuals(0.5, vec![0.0; PHASES]) {
            let mean = found.expect("residuals").mean;
            assert!((mean + 0.1 * 0.5 * 0.25).abs() < 1e-3, "{mean}");
        }
    }
}

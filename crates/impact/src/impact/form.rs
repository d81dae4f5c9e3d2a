//! The closed form of a phase: a function of the time on its clock, with its terms.
//!
//! In: the numbers of a wave, of a sum of harmonics or of a contact. Out: displacement and velocity
//! at any time, the same in another coordinate, and the terms that are worth writing.
//!
//! ```text
//! cosine        x = A cos(omega s + phi)                       harmonics   x = c + Re sum_k Z_k exp(i k omega s)
//! oscillation   x = c + Re[Z exp(i kappa s)]                   contact     x = x_c +- d(s), d a parabola and odd or all sines
//! ```

use std::f64::consts::PI;

use num_complex::Complex64;

use super::contact::SineSeries;

/// x as a function of the time s on the clock of a phase.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// x = amplitude cos(frequency s + phase).
    Cosine {
        /// Amplitude, with its sign.
        amplitude: f64,
        /// Angular frequency.
        frequency: f64,
        /// Phase, rad.
        phase: f64,
    },
    /// x = centre + Re[amplitude exp(i frequency s)] = centre + Re(amplitude) cos(..) -
    /// Im(amplitude) sin(..).
    Oscillation {
        /// The point oscillated about.
        centre: f64,
        /// Complex amplitude.
        amplitude: Complex64,
        /// Angular frequency.
        frequency: f64,
    },
    /// x = centre + Re sum_k Z_k exp(i k frequency s): a motion with all its harmonics.
    Harmonics {
        /// The constant part.
        centre: f64,
        /// Angular frequency of the first harmonic.
        frequency: f64,
        /// Number k and complex amplitude Z_k of each harmonic: Re(Z_k) cos(..) - Im(Z_k) sin(..).
        harmonics: Vec<(u32, Complex64)>,
    },
    /// x = barrier + inward d(s): a contact by the series of its depth.
    Contact {
        /// The position of the barrier.
        barrier: f64,
        /// 1 where the depth grows with x, -1 where it grows the other way.
        inward: f64,
        /// The depth.
        depth: SineSeries,
    },
}

/// A function of time in a closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeFunction {
    /// One.
    Constant,
    /// s (T - s), with T the duration of the phase.
    Parabola,
    /// A wave.
    Wave {
        /// `cos` or `sin`.
        function: &'static str,
        /// Its angular frequency.
        frequency: f64,
    },
}

impl Form {
    /// Largest deviation of the written series of a contact from the whole one, over the depth.
    pub const WRITTEN_CONTACT: f64 = 1e-4;

    /// The terms of a sum that are worth writing, in their order, with their coefficients: those
    /// that affect six digits of a flight, or a contact to [`Form::WRITTEN_CONTACT`]; none for the
    /// forms of one wave.
    pub fn felt_terms(&self) -> Vec<(TimeFunction, f64)> {
        let felt = match self {
            Self::Contact { .. } => 0.5 * Self::WRITTEN_CONTACT,
            _ => 5e-7,
        };
        if matches!(self, Self::Cosine { .. } | Self::Oscillation { .. }) {
            return vec![];
        }
        let (frequency, parabola, sum) = (self.frequency(), self.parabola(), self.harmonics());
        let waves = sum.iter().flat_map(|&(number, amplitude)| {
            let frequency = f64::from(number) * frequency;
            let wave = |function| TimeFunction::Wave { function, frequency };
            [(wave("cos"), amplitude.re), (wave("sin"), -amplitude.im)]
        });
        // A parabola is as large as its vertex.
        let size = |(term, value): &(TimeFunction, f64)| match term {
            TimeFunction::Constant | TimeFunction::Wave { .. } => value.abs(),
            TimeFunction::Parabola => value.abs() * (0.5 * PI / frequency).powi(2),
        };
        let moving: Vec<_> =
            std::iter::once((TimeFunction::Parabola, parabola)).chain(waves).collect();
        let largest = moving.iter().map(size).fold(0.0, f64::max);
        let terms = std::iter::once((TimeFunction::Constant, self.centre())).chain(moving);
        terms.filter(|term| size(term) > felt * largest).collect()
    }

    /// The constant part: the centre of the oscillation, or the position of the barrier.
    pub fn centre(&self) -> f64 {
        match *self {
            Self::Cosine { .. } => 0.0,
            Self::Oscillation { centre, .. } | Self::Harmonics { centre, .. } => centre,
            Self::Contact { barrier, .. } => barrier,
        }
    }

    /// Angular frequency of the first harmonic.
    pub fn frequency(&self) -> f64 {
        match self {
            Self::Cosine { frequency, .. }
            | Self::Oscillation { frequency, .. }
            | Self::Harmonics { frequency, .. } => *frequency,
            Self::Contact { depth, .. } => PI / depth.duration,
        }
    }

    /// The coefficient of s (T - s), with T the duration of the phase.
    pub fn parabola(&self) -> f64 {
        match self {
            Self::Contact { inward, depth, .. } => inward * depth.parabola,
            _ => 0.0,
        }
    }

    /// Number k and complex amplitude Z_k of each harmonic: Re(Z_k) cos(k frequency s) - Im(Z_k)
    /// sin(k frequency s).
    pub fn harmonics(&self) -> Vec<(u32, Complex64)> {
        match self {
            &Self::Cosine { amplitude, phase, .. } => vec![(1, amplitude * Complex64::cis(phase))],
            &Self::Oscillation { amplitude, .. } => vec![(1, amplitude)],
            Self::Harmonics { harmonics, .. } => harmonics.clone(),
            Self::Contact { inward, depth, .. } => {
                let sines = depth.sines().into_iter();
                sines.map(|(k, sine)| (k, Complex64::new(0.0, -inward * sine))).collect()
            }
        }
    }

    /// The motion in another coordinate, offset + sign x.
    pub(super) fn moved(&self, sign: f64, offset: f64) -> Self {
        match self {
            // A cosine oscillates about zero and ignores the offset.
            &Self::Cosine { amplitude, frequency, phase } => {
                Self::Cosine { amplitude: sign * amplitude, frequency, phase }
            }
            &Self::Oscillation { centre, amplitude, frequency } => Self::Oscillation {
                centre: offset + sign * centre,
                amplitude: sign * amplitude,
                frequency,
            },
            Self::Harmonics { centre, frequency, harmonics } => Self::Harmonics {
                centre: offset + sign * centre,
                frequency: *frequency,
                harmonics: harmonics.iter().map(|&(k, amplitude)| (k, sign * amplitude)).collect(),
            },
            Self::Contact { barrier, inward, depth } => Self::Contact {
                barrier: offset + sign * barrier,
                inward: sign * inward,
                depth: depth.clone(),
            },
        }
    }

    /// Displacement and velocity at the time s on the clock of the phase.
    pub fn phase_point_at(&self, elapsed: f64) -> (f64, f64) {
        match self {
            &Self::Cosine { amplitude, frequency, phase } => {
                let (sine, cosine) = (frequency * elapsed + phase).sin_cos();
                (amplitude * cosine, -amplitude * frequency * sine)
            }
            &Self::Oscillation { centre, amplitude, frequency } => {
                let turned = amplitude * Complex64::cis(frequency * elapsed);
                (centre + turned.re, -frequency * turned.im)
            }
            Self::Harmonics { centre, frequency, harmonics } => {
                // exp(i k phi) by turns of phi: one sine and cosine for all.
                let turn = Complex64::cis(frequency * elapsed);
                let (mut wave, mut reached) = (Complex64::ONE, 0);
                let (mut x, mut v) = (*centre, 0.0);
                for &(number, amplitude) in harmonics {
                    wave = match number.checked_sub(reached) {
                        Some(more) => wave * turn.powu(more),
                        None => turn.powu(number),
                    };
                    reached = number;
                    let turned = amplitude * wave;
                    x += turned.re;
                    v -= f64::from(number) * frequency * turned.im;
                }
                (x, v)
            }
            Self::Contact { barrier, inward, depth } => {
                let (depth, rate) = depth.phase_point_at(elapsed);
                (barrier + inward * depth, inward * rate)
            }
        }
    }
}

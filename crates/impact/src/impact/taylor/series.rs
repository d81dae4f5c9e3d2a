//! Initial values and storage of the series of a step, and their values at its end.
//!
//! Times are measured in a suitable unit, so that no coefficient over- or underflows, and stretched
//! within a step (`stretch`). `L` motions go through the same operations side by side; each gets
//! bit for bit the same result as alone.

use super::angle::sines_and_cosines;
use super::kernels::per_lane;
use super::{Loaded, StepEquation};
use crate::impact::polynomial::lanes::{values, values_of, variations};

/// Highest order of a series.
pub(super) const HIGHEST_ORDER: usize = 30;

/// Coefficients of the time in flight.
pub(super) const TIME_TERMS: usize = 4;

/// Number of last coefficients that determine the length of a step: a series may have gaps. At
/// touch v is a series in s^5, because v' = -gamma w^4 and w' = v/2.
pub(super) const LAST: usize = 5;

/// Coefficients of a series, those of `L` motions side by side.
pub(super) type LaneSeries<const L: usize> = [[f64; L]; HIGHEST_ORDER + 1];

/// The terms of equation (7) that act in at least one of the motions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Terms {
    pub(super) arctangent: bool,
    pub(super) excited: bool,
    pub(super) damped_contact: bool,
}

impl Terms {
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            arctangent: self.arctangent || other.arctangent,
            excited: self.excited || other.excited,
            damped_contact: self.damped_contact || other.damped_contact,
        }
    }
}

/// Initial values of the series of `L` motions: their states and parameters. In contact everything
/// is mirrored to the right side.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(super) struct Inputs<const L: usize> {
    /// x in flight, w = sqrt(x - x_r) in contact.
    pub(super) place: [f64; L],
    pub(super) velocity: [f64; L],
    /// In contact: the barrier; otherwise 0.
    pub(super) base: [f64; L],
    pub(super) sine: [f64; L],
    pub(super) cosine: [f64; L],
    /// sin and cos of eta t.
    pub(super) drive: [[f64; L]; 2],
    /// The unit of t, or of s.
    pub(super) unit: [f64; L],
    /// In contact: the largest w and the largest speed of Hertz's contact that began so.
    pub(super) hertz: [[f64; L]; 2],
    /// Coulomb's friction, alpha times the direction of motion.
    pub(super) dry: [f64; L],
    /// (2/pi) alpha in equation (6).
    pub(super) arctangent: [f64; L],
    pub(super) viscous: [f64; L],
    pub(super) beta: [f64; L],
    pub(super) eta: [f64; L],
    pub(super) gamma: [f64; L],
    pub(super) mu: [f64; L],
    /// The size of the motion, and the bound of the first term left out of a step.
    pub(super) size: [f64; L],
    pub(super) allowed: [f64; L],
    /// The bounds of x or w in this phase.
    pub(super) lower: [f64; L],
    pub(super) upper: [f64; L],
}

impl<const L: usize> Inputs<L> {
    pub(super) fn new() -> Self {
        let zero = [0.0; L];
        Self {
            place: zero,
            velocity: zero,
            base: zero,
            sine: zero,
            cosine: zero,
            drive: [zero; 2],
            unit: zero,
            hertz: [[1.0; L]; 2],
            dry: zero,
            arctangent: zero,
            viscous: zero,
            beta: zero,
            eta: zero,
            gamma: zero,
            mu: zero,
            size: zero,
            allowed: zero,
            lower: zero,
            upper: zero,
        }
    }
}

/// Number of auxiliary series, which only the equations use.
const SCRATCH: usize = 18;

/// The series of a step, and the auxiliary ones of its equations. The coefficients of eight lanes
/// never cross a cache line.
#[repr(align(64))]
pub(super) struct SeriesCoefficients<const L: usize> {
    /// x in flight, w in contact.
    pub(super) place: LaneSeries<L>,
    pub(super) velocity: LaneSeries<L>,
    /// Time since the start of the step.
    pub(super) time: LaneSeries<L>,
    pub(super) scratch: [LaneSeries<L>; SCRATCH],
    /// The known parts of the next coefficients of products, and of sines and cosines. They are
    /// stored here because as local variables they make eight motions side by side 8 % slower.
    pub(super) ahead: [[f64; L]; SCRATCH],
    pub(super) ahead_of_waves: [[[f64; L]; 2]; 2],
}

impl<const L: usize> SeriesCoefficients<L> {
    pub(super) fn new() -> Self {
        let zero = [[0.0; L]; HIGHEST_ORDER + 1];
        Self {
            place: zero,
            velocity: zero,
            time: zero,
            scratch: [zero; SCRATCH],
            ahead: [[0.0; L]; SCRATCH],
            ahead_of_waves: [[[0.0; L]; 2]; 2],
        }
    }
}

/// The values of the series at the end of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends<const L: usize> {
    pub(super) place: [f64; L],
    pub(super) velocity: [f64; L],
    pub(super) time: [f64; L],
    pub(super) variation: [f64; L],
    pub(super) sine: [f64; L],
    pub(super) cosine: [f64; L],
}

/// The values of one motion at the end of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepEndState {
    pub(super) place: f64,
    pub(super) velocity: f64,
    /// The time that the step takes.
    pub(super) time: f64,
    /// A bound on the change of the velocity within the step.
    pub(super) variation: f64,
    /// Sine and cosine of x, mirrored in contact.
    pub(super) sine: f64,
    pub(super) cosine: f64,
}

impl<const L: usize> Ends<L> {
    pub(super) fn new() -> Self {
        let zero = [0.0; L];
        Self { place: zero, velocity: zero, time: zero, variation: zero, sine: zero, cosine: zero }
    }

    pub(super) fn lane(&self, lane: usize) -> StepEndState {
        StepEndState {
            place: self.place[lane],
            velocity: self.velocity[lane],
            time: self.time[lane],
            variation: self.variation[lane],
            sine: self.sine[lane],
            cosine: self.cosine[lane],
        }
    }
}

impl<const L: usize> SeriesCoefficients<L> {
    /// The series of one motion: x or w, v, t.
    pub(super) fn lane(&self, order: usize, lane: usize) -> Loaded {
        let mut own = [[0.0; HIGHEST_ORDER + 1]; 3];
        for (own, all) in own.iter_mut().zip([&self.place, &self.velocity, &self.time]) {
            for (coefficient, lanes) in own.iter_mut().zip(all).take(order + 1) {
                *coefficient = lanes[lane];
            }
        }
        own
    }

    /// Place, velocity and time at these points; the time is a short polynomial in flight.
    #[inline(always)]
    pub(super) fn values(
        &self,
        at: &[f64; L],
        order: usize,
        equation: StepEquation,
    ) -> [[f64; L]; 3] {
        let order = order.min(HIGHEST_ORDER);
        let (place, velocity) = (&self.place[..=order], &self.velocity[..=order]);
        match equation {
            StepEquation::Flight => {
                let [place, velocity] = values_of([place, velocity], at);
                [place, velocity, values(&self.time[..TIME_TERMS], at)]
            }
            StepEquation::Contact => values_of([place, velocity, &self.time[..=order]], at),
        }
    }

    /// The values of the series where the steps end.
    #[inline(always)]
    pub(super) fn ends(
        &self,
        inputs: &Inputs<L>,
        lengths: &[f64; L],
        order: usize,
        equation: StepEquation,
    ) -> Ends<L> {
        let order = order.min(HIGHEST_ORDER);
        let [place, velocity, time] = self.values(lengths, order, equation);
        let angle = match equation {
            StepEquation::Flight => place,
            StepEquation::Contact => per_lane(|lane| inputs.base[lane] + place[lane] * place[lane]),
        };
        let (sine, cosine) = sines_and_cosines(&angle);
        Ends {
            place,
            velocity,
            time,
            variation: variations(&self.velocity[..=order], lengths),
            sine,
            cosine,
        }
    }
}

//! A record made ready for a fit: its quality, its turning points, its samples.

use crate::fit::answer::FitError;
use crate::fit::backbone::{BackbonePoint, backbone};
use crate::fit::integration::oscillating_integral;
use crate::fit::motion::Quantity;
use crate::fit::polynomial::median;
use crate::fit::quality::{Quality, part, quality};
use crate::fit::record::Record;
use crate::fit::sample_fit::Samples;
use crate::fit::turning_points::{Crossing, Swings};

/// A record of a fit, with what was found in it before any law.
#[derive(Clone, Debug)]
pub struct FittedRecord {
    /// The quality of the record.
    pub quality: Quality,
    /// Frequency and damping against amplitude, without any law.
    pub backbone: Vec<BackbonePoint>,
    /// The turning points.
    pub swings: Swings,
    /// The crossings of the centre.
    pub crossings: Vec<Crossing>,
    /// The samples that were left out since they lie far from their neighbours or from the best law, by their index in the record.
    pub outliers: Vec<usize>,
    /// The samples that were fitted.
    pub samples: Samples,
    /// The indices of these samples in the record.
    indices: Vec<usize>,
}

/// The part of a record that counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CountedPart {
    /// The free decay from its largest swing on.
    Decay,
    /// The part after a hold, whether it grows or decays.
    AfterRelease,
    /// All of it.
    All,
}

impl FittedRecord {
    /// Prepares a record. What counts is its free decay, of an equation of one's own all after the release, and all of a driven motion; with outliers, its spikes are among the
    /// samples too, but not among what turning points are found from.
    ///
    /// # Errors
    /// [`FitError`] if it does not swing or is saturated.
    pub(crate) fn new(
        record: &Record,
        counted: CountedPart,
        keep_outliers: bool,
    ) -> Result<Self, FitError> {
        /// The share of saturated samples above which a record is refused.
        const MOST: f64 = 0.3;
        /// The number of points of the backbone.
        const POINTS: usize = 12;
        let mut quality = quality(record)?;
        quality.start = match counted {
            CountedPart::Decay => quality.start,
            CountedPart::AfterRelease => quality.release,
            CountedPart::All => 0,
        };
        let (saturated, total) = (quality.saturated.len(), record.times.len());
        if saturated as f64 > MOST * total as f64 {
            return Err(FitError::Saturated { saturated, total });
        }
        let Record { times, values, quantity, .. } = quality.cleaned(record);
        let observed = Swings::find(&times, &values)?;
        let period = 2.0 * observed.half_period;
        let integral = |values: &[f64]| oscillating_integral(&times, values, period);
        let (swings, displacements) = match quantity {
            Quantity::Displacement => (observed.clone(), values),
            Quantity::Velocity | Quantity::Acceleration => {
                let once = integral(&values);
                let own = if quantity == Quantity::Velocity { once } else { integral(&once) };
                (Swings::find(&times, &own)?, own)
            }
        };
        let crossings = swings.crossings(&times, &displacements);
        let indices = quality.indices(total, keep_outliers);
        let Record { times, values, .. } = part(record, &indices);
        let [level, drift, _] = observed.centre;
        let samples = Samples {
            times,
            values,
            quantity,
            half_period: swings.half_period,
            middle: swings.middle,
            centre: [level, drift],
            weight: 1.0,
        };
        let spikes = quality.spikes.iter().filter(|index| **index >= quality.start).copied();
        let outliers = if keep_outliers { vec![] } else { spikes.collect() };
        let backbone = backbone(&swings, POINTS);
        Ok(Self { quality, backbone, swings, crossings, outliers, samples, indices })
    }

    /// Leaves out samples, given by their place among the samples in increasing order.
    pub(crate) fn leave_out(&mut self, places: &[usize]) {
        let is_kept = |place: &usize| places.binary_search(place).is_err();
        let kept: Vec<usize> = (0..self.indices.len()).filter(is_kept).collect();
        self.outliers.extend(places.iter().map(|place| self.indices[*place]));
        self.outliers.sort_unstable();
        let samples = &mut self.samples;
        samples.times = kept.iter().map(|place| samples.times[*place]).collect();
        samples.values = kept.iter().map(|place| samples.values[*place]).collect();
        self.indices = kept.iter().map(|place| self.indices[*place]).collect();
    }

    /// Refuses a record whose amplitude grows.
    ///
    /// # Errors
    /// [`FitError::Grows`].
    pub(crate) fn refuse_growth(&self) -> Result<(), FitError> {
        const GROWTH: f64 = 1.2;
        let amplitudes = self.swings.amplitudes();
        let third = (amplitudes.len() / 3).max(1);
        let from = median(amplitudes[..third].to_vec());
        let to = median(amplitudes[amplitudes.len() - third..].to_vec());
        if to > GROWTH * from { Err(FitError::Grows { from, to }) } else { Ok(()) }
    }
}

/// Gives residuals of several records the weights of their noise, in units of that of the first.
pub(crate) fn weigh(records: &mut [FittedRecord]) {
    // The swings of a velocity are those of its integral, whose noise is another one.
    let noise = |own: &FittedRecord| match own.samples.quantity {
        Quantity::Displacement => own.swings.noise,
        Quantity::Velocity | Quantity::Acceleration => own.quality.noise,
    };
    let Some(first) = records.first().map(noise) else { return };
    for own in records {
        let weight = first / noise(own);
        own.samples.weight = if weight.is_finite() && weight > 0.0 { weight } else { 1.0 };
    }
}

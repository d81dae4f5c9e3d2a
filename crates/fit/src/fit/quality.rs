//! The quality of a record: sampling, gaps, quantisation, saturation, the part that is a free decay.

use crate::fit::polynomial::median;
use crate::fit::record::Record;
use crate::fit::spikes::{local_noise, spikes};
use crate::fit::turning_points::{Swings, SwingsError};

/// The quality of a record, before any law.
#[derive(Clone, Debug, PartialEq)]
pub struct Quality {
    /// The usual time between samples.
    pub step: f64,
    /// The standard deviation of the noise between neighbouring samples.
    pub noise: f64,
    /// The step between values if they are quantised; `None` if it lies below a fiftieth of the noise.
    pub quantum: Option<f64>,
    /// Gaps: the index of the last sample before each, and the times around it.
    pub gaps: Vec<(usize, [f64; 2])>,
    /// The samples that lie on a flat top or bottom: their indices.
    pub saturated: Vec<usize>,
    /// Single samples far from the curve through their neighbours: their indices.
    pub spikes: Vec<usize>,
    /// The first sample after a hold: that of the record where nothing is held.
    pub release: usize,
    /// The first sample of the free decay.
    pub start: usize,
}

/// Examines a record.
///
/// # Errors
/// [`SwingsError`] if it does not swing.
pub fn quality(record: &Record) -> Result<Quality, SwingsError> {
    const GAP: f64 = 3.5;
    let Record { times, values, .. } = record;
    let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let step = median(steps.clone());
    let noise = local_noise(times, values);
    let is_gap = |(_, own): &(usize, &f64)| **own > GAP * step;
    let gaps = steps.iter().enumerate().filter(is_gap);
    let gaps = gaps.map(|(index, _)| (index, [times[index], times[index + 1]])).collect();
    let spikes = spikes(times, values, quantum(values).unwrap_or(0.0));
    // A spike above a flat top would hide it, and one between the steps of a record its quantum.
    let kept: Vec<usize> =
        (0..times.len()).filter(|index| spikes.binary_search(index).is_err()).collect();
    let clean = part(record, &kept);
    let quantum = quantum(&clean.values);
    let swings = Swings::find(&clean.times, &clean.values)?;
    let saturated = saturated(&clean, &swings, quantum.unwrap_or(0.0));
    let saturated = saturated.into_iter().map(|place| kept[place]).collect();
    let release = release(&clean, &swings, noise);
    let start = start(&clean, &swings, release);
    // The first sample may be a spike.
    let [release, start] = [release, start].map(|place| if place == 0 { 0 } else { kept[place] });
    Ok(Quality {
        step,
        noise,
        quantum: quantum.filter(|own| *own > 0.02 * noise),
        gaps,
        saturated,
        spikes,
        release,
        start,
    })
}

/// These samples of a record.
pub(crate) fn part(record: &Record, indices: &[usize]) -> Record {
    Record {
        times: indices.iter().map(|index| record.times[*index]).collect(),
        values: indices.iter().map(|index| record.values[*index]).collect(),
        ..*record
    }
}

/// The smallest distance between different values, if all values are whole multiples of it from the first one.
fn quantum(values: &[f64]) -> Option<f64> {
    const EXACT: f64 = 1e-3;
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let size = sorted.last()? - sorted.first()?;
    let distances = sorted.windows(2).map(|pair| pair[1] - pair[0]);
    let least = distances.filter(|own| *own > 1e-9 * size).reduce(f64::min)?;
    let is_multiple = |value: &f64| {
        let number = (value - sorted[0]) / least;
        (number - number.round()).abs() < EXACT * number.abs().max(1.0).sqrt().max(1.0)
    };
    // Values of many digits are multiples of their rounding, which is no quantum to speak of.
    let distinct = values.len() as f64 * 4.0;
    (size / least < distinct && sorted.iter().all(is_multiple)).then_some(least)
}

/// The samples on flat tops: runs at the largest or smallest value that last longer than a rounded wave stays there.
fn saturated(record: &Record, swings: &Swings, quantum: f64) -> Vec<usize> {
    const FEWEST: usize = 4;
    let Record { times, values, .. } = record;
    let rate = std::f64::consts::PI / swings.half_period;
    let amplitude = swings.amplitudes().into_iter().fold(0.0, f64::max);
    // A wave stays within half a quantum of its top for 2 sqrt(q/A)/w.
    let usual = 2.0 * (quantum / amplitude).sqrt() / rate;
    let mut found = vec![];
    for limit in [f64::max as fn(f64, f64) -> f64, f64::min] {
        let Some(extreme) = values.iter().copied().reduce(limit) else { continue };
        let mut from = 0;
        while from < values.len() {
            let run = values[from..].iter().take_while(|value| **value == extreme).count();
            if run >= FEWEST && times[from + run - 1] - times[from] > 2.0 * usual {
                found.extend(from..from + run);
            }
            from += run.max(1);
        }
    }
    found.sort_unstable();
    found
}

/// The first sample of the free decay: after the release, and at the largest turning point if those before it are smaller. What grows
/// for more than half of its swings is no decay, and is left whole.
fn start(record: &Record, swings: &Swings, release: usize) -> usize {
    const SMALLER: f64 = 0.9;
    let amplitudes = swings.amplitudes();
    let largest = amplitudes.iter().copied().fold(0.0, f64::max);
    let peak = amplitudes.iter().position(|own| *own >= 0.97 * largest).unwrap_or(0);
    let grows = amplitudes[..peak].iter().any(|own| *own < SMALLER * largest);
    match grows && 2 * peak <= amplitudes.len() {
        true => release.max(record.times.partition_point(|time| *time < swings.points[peak].time)),
        false => release,
    }
}

/// The first sample after a hold.
fn release(record: &Record, swings: &Swings, noise: f64) -> usize {
    const HELD: f64 = 6.0;
    let Record { times, values, .. } = record;
    let largest = swings.amplitudes().into_iter().fold(0.0, f64::max);
    // A body that is held shows its noise alone.
    let level = values.first().copied().unwrap_or(0.0);
    let moved =
        values.iter().position(|value| (value - level).abs() > HELD * noise + 1e-3 * largest);
    let moved = moved.unwrap_or(0);
    match times[moved] - times[0] > 0.5 * swings.half_period {
        true => moved,
        false => 0,
    }
}

impl Quality {
    /// The record without what is no free decay, without saturated samples and without spikes.
    pub fn cleaned(&self, record: &Record) -> Record {
        part(record, &self.indices(record.times.len(), false))
    }

    /// The indices of the samples of the free decay that are not saturated, with or without spikes.
    pub(crate) fn indices(&self, count: usize, with_spikes: bool) -> Vec<usize> {
        let is_kept = |index: &usize| {
            *index >= self.start
                && self.saturated.binary_search(index).is_err()
                && (with_spikes || self.spikes.binary_search(index).is_err())
        };
        (0..count).filter(is_kept).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A decay with a deterministic ripple in place of noise.
    fn decay(count: usize) -> Record {
        let times: Vec<f64> = (0..count).map(|index| 0.02 * index as f64).collect();
        let value = |t: &f64| (-0.02 * t).exp() * (2.0 * t).cos() + 1e-3 * (1000.0 * t * t).sin();
        Record { values: times.iter().map(value).collect(), times, ..Record::default() }
    }

    #[test]
    fn a_clean_record_is_left_as_it_is() {
        let record = decay(3000);
        let found = quality(&record).unwrap();
        assert!(found.gaps.is_empty() && found.saturated.is_empty(), "{found:?}");
        assert_eq!((found.start, found.quantum), (0, None));
        assert_eq!(found.cleaned(&record), record);
    }

    #[test]
    fn flat_tops_gaps_and_steps_are_named() {
        let mut record = decay(3000);
        record.values.iter_mut().for_each(|value| *value = value.min(0.7));
        let found = quality(&record).unwrap();
        assert!(found.saturated.len() > 50, "{}", found.saturated.len());
        assert!(found.saturated.iter().all(|index| record.values[*index] == 0.7));
        let mut record = decay(3000);
        record.times.drain(1000..1100);
        record.values.drain(1000..1100);
        record.values.iter_mut().for_each(|value| *value = (*value * 200.0).round() / 200.0);
        let found = quality(&record).unwrap();
        assert_eq!(found.gaps.iter().map(|gap| gap.0).collect::<Vec<_>>(), [999]);
        assert!((found.quantum.unwrap() - 0.005).abs() < 1e-9 && found.saturated.is_empty());
    }

    #[test]
    fn a_hold_before_the_release_is_cut() {
        let mut record = decay(3000);
        let held: Vec<f64> =
            (0..400).map(|index| 1.0 + 1e-3 * (index as f64 * 7.7).sin()).collect();
        record.values.splice(0..0, held);
        record.times = (0..record.values.len()).map(|index| 0.02 * index as f64).collect();
        let found = quality(&record).unwrap();
        assert!((400..430).contains(&found.start), "{}", found.start);
    }
}

//! Single wrong samples, found before any law: by Hampel's identifier, with the cubic through the neighbours in place of their median.
//!
//! ```text
//! d_i = y_i - p_i(t_i),  p_i: cubic through the two neighbours on both sides      spike: |d_i| > 6 S_i  and  |d_i| > step_i
//! ```
//!
//! S_i is the usual size of d_i, from the median of all; step_i the third largest of the six steps between neighbours about the sample. A median
//! would take the tops of coarsely sampled swings for spikes, and without the steps an impact, at which the velocity jumps, would be
//! one. The worst of neighbouring candidates is taken out first, and the search is repeated without it.
//! (F. R. Hampel, *J. Am. Stat. Assoc.* 69 (1974) 383.)

use crate::fit::polynomial::median;

/// The distance of a sample from the cubic through its four neighbours, and the factor by which independent noise is larger in it.
fn distance(time: &[f64], value: &[f64]) -> [f64; 2] {
    let (mut sum, mut square) = (0.0, 1.0);
    for i in [0, 1, 3, 4] {
        let mut weight = 1.0;
        for j in [0, 1, 3, 4] {
            if i != j {
                weight *= (time[2] - time[j]) / (time[i] - time[j]);
            }
        }
        sum += weight * value[i];
        square += weight * weight;
    }
    [(value[2] - sum).abs(), square.sqrt()]
}

/// The standard deviation of the noise: from the distance of each sample from the cubic through its four neighbours.
pub fn local_noise(times: &[f64], values: &[f64]) -> f64 {
    let distances = times.windows(5).zip(values.windows(5)).map(|(time, value)| {
        let [distance, factor] = distance(time, value);
        distance / factor
    });
    median(distances.collect()) / 0.6745
}

/// The indices of the spikes of a record with increasing times; `quantum` is the step between values, or zero. There are none if too
/// many samples look like it: then the law itself jumps, or the samples are too far apart.
pub fn spikes(times: &[f64], values: &[f64], quantum: f64) -> Vec<usize> {
    const SHARE: f64 = 0.05;
    const PASSES: usize = 20;
    let mut kept: Vec<usize> = (0..times.len()).collect();
    let mut found = vec![];
    let mut usual = 0.0;
    for _ in 0..PASSES {
        let [own_times, own_values] =
            [times, values].map(|all| kept.iter().map(|index| all[*index]).collect::<Vec<f64>>());
        let places;
        (places, usual) = candidates(&own_times, &own_values, quantum);
        if places.is_empty() {
            break;
        }
        found.extend(places.iter().map(|place| kept[*place]));
        if found.len() as f64 > SHARE * times.len() as f64 {
            return vec![];
        }
        let mut wrong = places.into_iter().peekable();
        let mut place = 0;
        kept.retain(|_| {
            let is_wrong = wrong.next_if_eq(&place).is_some();
            place += 1;
            !is_wrong
        });
    }
    // A good sample between two spikes may have been taken for one: what agrees with its neighbours without them is taken back, the
    // nearest first.
    loop {
        let distances = found.iter().enumerate().filter_map(|(place, index)| {
            let after = kept.partition_point(|other| other < index);
            let around = kept.get(after.checked_sub(2)?..after + 2)?;
            let five = [around[0], around[1], *index, around[2], around[3]];
            let [distance, factor] =
                distance(&five.map(|index| times[index]), &five.map(|index| values[index]));
            Some((place, after, distance / factor))
        });
        let nearest = distances.min_by(|one, other| one.2.total_cmp(&other.2));
        let Some((place, after, _)) = nearest.filter(|own| own.2 <= FAR * usual) else { break };
        kept.insert(after, found.swap_remove(place));
    }
    found.sort_unstable();
    found
}

/// The number of usual distances beyond which a sample is a spike.
const FAR: f64 = 6.0;

/// The places of samples that are spikes, none beside another, and the usual distance.
fn candidates(times: &[f64], values: &[f64], quantum: f64) -> (Vec<usize>, f64) {
    const BESIDE: usize = 2;
    let windows = times.windows(5).zip(values.windows(5));
    let distances: Vec<[f64; 2]> = windows.map(|(time, value)| distance(time, value)).collect();
    let relative = distances.iter().map(|[distance, factor]| distance / factor);
    let relative: Vec<f64> = relative.collect();
    let usual = (median(relative.clone()) / 0.6745).max(quantum / 3.0);
    let is_candidate = |index: &usize| {
        let around = index.saturating_sub(BESIDE)..=(index + BESIDE).min(relative.len() - 1);
        relative[*index] > FAR * usual
            && distances[*index][0] > usual_step(values, index + BESIDE)
            && relative[around].iter().all(|other| *other <= relative[*index])
    };
    let places = (0..relative.len()).filter(is_candidate).map(|index| index + BESIDE);
    let mut places: Vec<usize> = places.collect();
    places.dedup_by(|later, earlier| *later - *earlier <= BESIDE);
    (places, usual)
}

/// The third largest of the steps between neighbouring samples about one of them, without those that it takes part in.
fn usual_step(values: &[f64], index: usize) -> f64 {
    const REACH: usize = 4;
    const RANK: usize = 2;
    let before = &values[index.saturating_sub(REACH)..index];
    let after = &values[index + 1..(index + 1 + REACH).min(values.len())];
    let mut steps: Vec<f64> = [before, after]
        .iter()
        .flat_map(|side| side.windows(2).map(|pair| (pair[1] - pair[0]).abs()))
        .collect();
    steps.sort_by(|one, other| other.total_cmp(one));
    steps.get(RANK).or(steps.last()).copied().unwrap_or(f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    /// A decay with 24 samples in a period and uniform noise.
    fn decay(seed: u64) -> (Vec<f64>, Vec<f64>) {
        let mut generator = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let times: Vec<f64> = (0..2000)
            .map(|index| 0.26 * (f64::from(index) + 0.3 * generator.random::<f64>()))
            .collect();
        let values = times
            .iter()
            .map(|t| 0.3 + (-0.002 * t).exp() * t.cos() + 0.01 * (generator.random::<f64>() - 0.5));
        (times.clone(), values.collect())
    }

    #[test]
    fn spikes_are_found_wherever_they_lie() {
        for seed in 0..10 {
            let (times, mut values) = decay(seed);
            assert!(spikes(&times, &values, 0.0).is_empty());
            let mut generator = rand_chacha::ChaCha8Rng::seed_from_u64(100 + seed);
            let mut wrong: Vec<usize> = (0..20).map(|_| generator.random_range(3..1997)).collect();
            wrong.sort_unstable();
            wrong.dedup();
            for index in &wrong {
                values[*index] += if generator.random::<bool>() { 1.0 } else { -1.5 };
            }
            assert_eq!(spikes(&times, &values, 0.0), wrong, "{seed}");
        }
    }

    #[test]
    fn swings_impacts_and_steps_are_no_spikes() {
        // Five samples in a half swing.
        let times: Vec<f64> = (0..400).map(|index| 0.63 * f64::from(index)).collect();
        let coarse: Vec<f64> = times.iter().map(|t| t.cos()).collect();
        assert!(spikes(&times, &coarse, 0.0).is_empty());
        // A rounded wave, and one that bounces and loses speed.
        let rounded: Vec<f64> =
            times.iter().map(|t| (30.0 * (0.03 * t).cos()).round() / 30.0).collect();
        assert!(spikes(&times, &rounded, 1.0 / 30.0).is_empty());
        let bouncing: Vec<f64> = times
            .iter()
            .map(|t| (0.25 * t).rem_euclid(std::f64::consts::PI).sin() * (-0.01 * t).exp())
            .collect();
        assert!(spikes(&times, &bouncing, 0.0).is_empty());
    }
}

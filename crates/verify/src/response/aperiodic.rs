//! How a simulation goes on that has not come to repeat itself: after many periods, with two frequencies,
//! in chaos, or still on its way.
//!
//! ```text
//! x(k T) = a_0 + sum_m (a_m cos(m theta k) + b_m sin(m theta k)) + k (a' cos(theta k) + b' sin(theta k))        (1)
//! theta <- theta + (b_1 a' - a_1 b')/(a_1^2 + b_1^2),     growth a period (a_1 a' + b_1 b')/(a_1^2 + b_1^2)     (2)
//! lambda = <ln(d_(k+1)/d)>/T          beside it a motion that begins anew at the distance d after every period  (3)
//! ```
//!
//! A motion of two frequencies, seen once a period T of the drive, turns by theta each time on a closed curve:
//! (1) is fitted to it by least squares and theta improved by (2), from the strongest line of the
//! spectrum on (J. Laskar, *Physica D* 67 (1993) 257). Where the sum leaves next to nothing, and what
//! turns neither grows nor decays, the motion is quasi-periodic. Otherwise the largest Lyapunov exponent
//! (3) decides (G. Benettin, L. Galgani, J.-M. Strelcyn, *Phys. Rev. A* 14 (1976) 2338). In: the state at
//! the beginning of a period, and a way to follow it over one. Out: the kind of motion. The cost is that of
//! 512 periods.

use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector};

use crate::numeric::harmonics::Transform;

/// The periods that are looked at.
const PERIODS: usize = 256;

/// Positions within a period.
pub(super) const SAMPLES: usize = 16;

/// The course of a motion that does not repeat itself.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(untagged))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum AperiodicMotion {
    /// A motion of two frequencies.
    QuasiPeriodic(QuasiPeriodicMotion),
    /// A motion from which those nearby part.
    Chaotic(ChaoticMotion),
    /// A motion that repeats itself but for whole turns of an angle.
    Rotating(RotatingMotion),
    /// A motion that shows none of these.
    Unsettled(UnsettledMotion),
}

/// A motion of two frequencies: that of the drive, or of so many of its periods as a motion takes, and another.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct QuasiPeriodicMotion {
    /// The angular frequency of the strongest part that is no harmonic of the first.
    pub second_frequency: f64,
}

/// A motion from which those nearby part exponentially.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ChaoticMotion {
    /// The largest Lyapunov exponent, per unit of time.
    pub lyapunov_exponent: f64,
    /// Its standard error.
    pub lyapunov_error: f64,
}

/// A motion that goes round: it repeats itself but for whole turns of 2 pi.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RotatingMotion {
    /// The number of turns, negative where the angle decreases; of several angles, of that with the most of them.
    pub turns: i64,
    /// The number of periods of the motion that they take.
    pub in_periods: usize,
}

/// A motion that neither repeats itself nor is quasi-periodic or chaotic, as far as it was followed: it may
/// still be on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct UnsettledMotion {
    /// The number of periods of the motion over which it was followed further.
    pub followed_periods: usize,
}

/// A period of a motion.
pub(super) struct PeriodSamples {
    /// Positions at equal steps from its beginning, [`SAMPLES`] of them.
    pub(super) positions: Vec<f64>,
    /// The state at its end.
    pub(super) end: Vec<f64>,
}

/// How a motion goes on.
pub(super) enum LaterMotion {
    /// It repeats itself after so many periods, more than one, from a state on.
    Periodic(usize, Vec<f64>),
    /// It does not.
    Aperiodic(AperiodicMotion),
}

impl LaterMotion {
    /// The course of a motion with the angular frequency `omega` of its period, from the state at the
    /// beginning of one; `period` follows a state over a period, and `angles` are the states of which whole
    /// turns change nothing. `None` if the motion cannot be followed.
    pub(super) fn of(
        start: &[f64],
        angles: &[usize],
        omega: f64,
        mut period: impl FnMut(&[f64]) -> Option<PeriodSamples>,
    ) -> Option<Self> {
        let mut states = vec![start.to_vec()];
        let mut positions = Vec::with_capacity(PERIODS * SAMPLES);
        for index in 0..PERIODS {
            let samples = period(&states[index])?;
            positions.extend(samples.positions);
            states.push(samples.end);
        }
        match returns_after(&states, angles) {
            Some((count, 0)) if count > 1 => return Some(Self::Periodic(count, states.pop()?)),
            Some((in_periods, turns)) if turns != 0 => {
                let motion = RotatingMotion { turns, in_periods };
                return Some(Self::Aperiodic(AperiodicMotion::Rotating(motion)));
            }
            _ => {}
        }
        if let Some(turn) = turn_of(&positions) {
            let motion =
                QuasiPeriodicMotion { second_frequency: strongest_line(&positions, turn) * omega };
            return Some(Self::Aperiodic(AperiodicMotion::QuasiPeriodic(motion)));
        }
        let unsettled = UnsettledMotion { followed_periods: PERIODS };
        let unsettled = Self::Aperiodic(AperiodicMotion::Unsettled(unsettled));
        let time = TAU / omega;
        let Some([exponent, error]) = lyapunov_exponent(&states, time, period) else {
            return Some(unsettled);
        };
        /// Powers of e by which motions nearby part at least; across a quasi-periodic motion they part in
        /// proportion to the time, which is less.
        const LEAST: f64 = 12.0;
        let is_chaotic = exponent > 2.0 * error && exponent * time * PERIODS as f64 > LEAST;
        let chaotic = ChaoticMotion { lyapunov_exponent: exponent, lyapunov_error: error };
        let chaotic = Self::Aperiodic(AperiodicMotion::Chaotic(chaotic));
        Some(if is_chaotic { chaotic } else { unsettled })
    }
}

/// The number of periods after which a motion repeats itself in the end, or will once what decays is gone, from its
/// states after every period, and the whole turns of the angle that turns most; `None` if it does not.
fn returns_after(states: &[Vec<f64>], angles: &[usize]) -> Option<(usize, i64)> {
    /// The largest number, and that of states which are compared with those so many periods before.
    const LONGEST: usize = 64;
    const STATES: usize = 16;
    /// Distance, in the sizes of the states, at which they are the same, if it is not larger over many times as many
    /// periods, as where two frequencies are nearly in step; and at which they come to be if it has fallen by half
    /// within half of all periods.
    const SAME: f64 = 1e-4;
    const MANY: usize = 128;
    const NEAR: f64 = 1e-3;
    let mut sizes = sizes_of(states);
    for angle in angles {
        sizes[*angle] = sizes[*angle].min(PI);
    }
    let turns = |way: f64| (way / TAU).round();
    let apart = |end: usize, count: usize| {
        let states_of = |index: usize| states[index].iter().zip(&states[index - count]);
        let ways = (end - STATES..end).flat_map(|index| states_of(index).zip(&sizes).enumerate());
        let ways = ways.filter(|(_, (_, size))| **size > 0.0);
        let parts = ways.map(|(index, ((one, other), size))| {
            let way = one - other;
            let whole = if angles.contains(&index) { TAU * turns(way) } else { 0.0 };
            (way - whole).abs() / size
        });
        parts.fold(0.0, f64::max)
    };
    let (half, end) = (states.len() / 2, states.len());
    let repeats = |count: &usize| {
        let now = apart(end, *count);
        let comes_to_be = now <= NEAR && now <= 0.5 * apart(half, *count);
        comes_to_be || (now <= SAME && apart(end, MANY - MANY % count) <= 2.0 * SAME)
    };
    let count = (1..=LONGEST).find(repeats)?;
    let ways = angles.iter().map(|angle| states[end - 1][*angle] - states[end - 1 - count][*angle]);
    let most = ways.map(turns).max_by(|one, other| one.abs().total_cmp(&other.abs()));
    Some((count, most.unwrap_or(0.0) as i64))
}

/// Half of the way of each state from its lowest to its highest value; zero for one that only varies by rounding.
fn sizes_of(states: &[Vec<f64>]) -> Vec<f64> {
    /// Ratio to the largest value of all states below which a difference is rounding.
    const ROUNDING: f64 = 1e-10;
    let largest = states.iter().flatten().map(|value| value.abs()).fold(0.0, f64::max);
    let size = |index: usize| {
        let values = states.iter().map(|state| state[index]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (f64::min(low, value), f64::max(high, value))
        });
        let size = 0.5 * (high - low);
        if size > ROUNDING * largest { size } else { 0.0 }
    };
    (0..states.first().map_or(0, Vec::len)).map(size).collect()
}

/// The angle by which a motion of two frequencies turns in a period; `None` if it is no such motion. In:
/// its positions, [`SAMPLES`] a period.
fn turn_of(positions: &[f64]) -> Option<f64> {
    /// The largest part of a motion that the sum may leave, and the largest growth or decay over all periods.
    const LEFT: f64 = 1e-3;
    let values: Vec<f64> = positions.iter().step_by(SAMPLES).copied().collect();
    let count = values.len();
    let mean = values.iter().sum::<f64>() / count as f64;
    let window = |index: usize| 1.0 - (TAU * index as f64 / count as f64).cos();
    let windowed: Vec<f64> =
        values.iter().enumerate().map(|(index, value)| (value - mean) * window(index)).collect();
    let lines = Transform::new(count).harmonics(&windowed, count / 2);
    let size = |line: usize| lines.cosines[line].hypot(lines.sines[line]);
    let strongest = (1..count / 2).max_by(|one, other| size(*one).total_cmp(&size(*other)))?;
    let first = TAU * strongest as f64 / count as f64;
    // The strongest line may be a multiple of the turn.
    let turns = [
        first,
        first / 2.0,
        PI - first / 2.0,
        first / 3.0,
        (TAU - first) / 3.0,
        (TAU + first) / 3.0,
    ];
    turns.into_iter().find_map(|mut turn| {
        const ROUNDS: usize = 6;
        let mut fit = Fit::of(&values, turn)?;
        for _ in 0..ROUNDS {
            turn += fit.advance;
            fit = Fit::of(&values, turn)?;
        }
        let lasts =
            (fit.growth * count as f64).abs() <= LEFT && fit.advance.abs() * count as f64 <= LEFT;
        (lasts && fit.left <= LEFT).then_some(turn)
    })
}

/// The sum (1) of a turn, fitted to the positions at the beginnings of periods.
struct Fit {
    /// The root mean square of what it leaves, relative to that of the distances from the mean.
    left: f64,
    /// The angle by which the turn is too small.
    advance: f64,
    /// The relative growth of what turns, each period.
    growth: f64,
}

impl Fit {
    fn of(values: &[f64], turn: f64) -> Option<Self> {
        /// Multiples of the turn.
        const MULTIPLES: usize = 12;
        let count = values.len();
        let middle = 0.5 * (count - 1) as f64;
        let table = DMatrix::from_fn(count, 2 * MULTIPLES + 3, |row, column| {
            let period = row as f64 - middle;
            let wave = |index: usize, multiple: usize| {
                let angle = multiple as f64 * turn * period;
                if index.is_multiple_of(2) { angle.cos() } else { angle.sin() }
            };
            match column {
                0 => 1.0,
                1 | 2 => period / middle * wave(column - 1, 1),
                _ => wave(column - 3, 1 + (column - 3) / 2),
            }
        });
        let mean = values.iter().sum::<f64>() / count as f64;
        let values = DVector::from_iterator(count, values.iter().map(|value| value - mean));
        let size = values.norm();
        let solution = table.clone().svd(true, true).solve(&values, 1e-9).ok()?;
        let left = (&values - table * &solution).norm() / size;
        let [slope_cosine, slope_sine] = [solution[1] / middle, solution[2] / middle];
        let [cosine, sine] = [solution[3], solution[4]];
        let square = cosine * cosine + sine * sine;
        let fit = Self {
            left,
            advance: (sine * slope_cosine - cosine * slope_sine) / square,
            growth: (cosine * slope_cosine + sine * slope_sine) / square,
        };
        (fit.left.is_finite() && fit.advance.is_finite()).then_some(fit)
    }
}

/// The frequency, relative to that of the period, of the strongest part of a motion of two frequencies
/// that is no harmonic of the period, from its positions and its turn in a period.
fn strongest_line(positions: &[f64], turn: f64) -> f64 {
    const HARMONICS: i32 = 5;
    const MULTIPLES: i32 = 2;
    let count = positions.len() as f64;
    let strength = |frequency: f64| {
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (index, position) in positions.iter().enumerate() {
            let window = 1.0 - (TAU * index as f64 / count).cos();
            let angle = TAU * frequency * index as f64 / SAMPLES as f64;
            cosine += window * position * angle.cos();
            sine += window * position * angle.sin();
        }
        f64::hypot(cosine, sine)
    };
    let multiples = (-MULTIPLES..=MULTIPLES).filter(|multiple| *multiple != 0);
    let lines = multiples.flat_map(|multiple| {
        (0..=HARMONICS).map(move |harmonic| f64::from(harmonic) + f64::from(multiple) * turn / TAU)
    });
    let lines = lines.filter(|frequency| *frequency > 0.0);
    let strongest = lines.map(|frequency| (frequency, strength(frequency)));
    let strongest = strongest.max_by(|one, other| one.1.total_cmp(&other.1));
    strongest.map_or(turn / TAU, |(frequency, _)| frequency)
}

/// The largest Lyapunov exponent of a motion by its states after every period, with its standard error,
/// from the means of ten parts. `None` if a motion nearby cannot be followed or falls together with it.
fn lyapunov_exponent(
    states: &[Vec<f64>],
    time: f64,
    mut period: impl FnMut(&[f64]) -> Option<PeriodSamples>,
) -> Option<[f64; 2]> {
    const PARTS: usize = 10;
    /// Distance at which the second motion begins, relative to the sizes of the states.
    const APART: f64 = 1e-7;
    let sizes = sizes_of(states);
    let mut away: Vec<f64> = sizes.iter().map(|size| APART * size).collect();
    let distance = |away: &[f64]| {
        let parts = away.iter().zip(&sizes).filter(|(_, size)| **size > 0.0);
        parts.map(|(away, size)| (away / size).powi(2)).sum::<f64>().sqrt()
    };
    let mut growths = Vec::with_capacity(states.len());
    for pair in states.windows(2) {
        let begin: Vec<f64> = pair[0].iter().zip(&away).map(|(state, away)| state + away).collect();
        let end = period(&begin)?.end;
        let apart: Vec<f64> = end.iter().zip(&pair[1]).map(|(one, other)| one - other).collect();
        let (before, after) = (distance(&away), distance(&apart));
        if !(before > 0.0 && after > 0.0 && after.is_finite()) {
            return None;
        }
        growths.push((after / before).ln() / time);
        away = apart.iter().map(|apart| apart * (APART / after)).collect();
    }
    // The first part turns the distance into the direction that grows.
    let parts = growths.chunks_exact(growths.len() / (PARTS + 1)).skip(1);
    let means: Vec<f64> = parts.map(|part| part.iter().sum::<f64>() / part.len() as f64).collect();
    let number = means.len() as f64;
    let mean = means.iter().sum::<f64>() / number;
    let square: f64 = means.iter().map(|value| (value - mean).powi(2)).sum();
    Some([mean, (square / (number * (number - 1.0))).sqrt()])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of a function of time with the period one.
    fn sampled(position: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..PERIODS * SAMPLES).map(|index| position(index as f64 / SAMPLES as f64)).collect()
    }

    /// Of cos(2 pi r t) + cos(2 pi t)/2 + cos(2 pi (2 r - 1) t)/10 the second frequency is r, whichever its
    /// place beside the first; a sum that decays by a part in a hundred over all periods has none, and
    /// neither has one of three frequencies.
    #[test]
    fn two_frequencies_are_found_and_no_others() {
        let turning = |angle: f64| (TAU * angle).cos();
        for ratio in [0.041_37, 0.381_966, 0.618_034, 1.040_5, 2.236_07] {
            let own = |t: f64| {
                turning(ratio * t) + 0.5 * turning(t) + 0.1 * turning((2.0 * ratio - 1.0) * t)
            };
            let positions = sampled(own);
            let turn = turn_of(&positions).expect("two frequencies");
            let found = strongest_line(&positions, turn);
            assert!((found - ratio).abs() < 1e-7, "{ratio}: {found}");
            let decaying = sampled(|t| own(t) * (1.0 - 0.01 * t / PERIODS as f64));
            assert!(turn_of(&decaying).is_none(), "{ratio} decays");
            let third = sampled(|t| own(t) + 0.05 * turning(std::f64::consts::E * t));
            assert!(turn_of(&third).is_none(), "{ratio} of three");
        }
    }

    /// The map z -> 1.9 z of a circle parts nearby motions by 1.9 a period; a turn does not part them.
    #[test]
    fn chaos_is_told_from_what_turns() {
        let stretching = |state: &[f64]| {
            let end = (1.9 * state[0]).rem_euclid(1.0);
            Some(PeriodSamples { positions: vec![state[0]; SAMPLES], end: vec![end] })
        };
        let Some(LaterMotion::Aperiodic(found)) = LaterMotion::of(&[0.3], &[], TAU, stretching)
        else {
            panic!("it repeats itself")
        };
        let AperiodicMotion::Chaotic(found) = found else { panic!("{found:?}") };
        assert!((found.lyapunov_exponent - 1.9_f64.ln()).abs() < 1e-3, "{found:?}");
        let turning = |state: &[f64]| {
            let position = |part: f64| (state[0] + part / SAMPLES as f64).sin();
            let positions = (0..SAMPLES).map(|part| position(part as f64)).collect();
            Some(PeriodSamples { positions, end: vec![state[0] + 1.0] })
        };
        let Some(LaterMotion::Aperiodic(found)) = LaterMotion::of(&[0.0], &[], TAU, turning) else {
            panic!("it repeats itself")
        };
        let AperiodicMotion::QuasiPeriodic(found) = found else { panic!("{found:?}") };
        assert!((found.second_frequency - 1.0).abs() < 1e-7, "{found:?}");
    }

    /// A turn of 5/12 with a disturbance that decays repeats itself after twelve periods.
    #[test]
    fn a_motion_of_many_periods_is_one() {
        let turning = |state: &[f64]| {
            let (sine, cosine) = (TAU * 5.0 / 12.0).sin_cos();
            let pull = 1.5 - 0.5 * state[0].hypot(state[1]);
            let [x, y] = [state[0] * pull, state[1] * pull];
            let end = vec![x * cosine - y * sine, x * sine + y * cosine];
            Some(PeriodSamples { positions: vec![state[0]; SAMPLES], end })
        };
        let Some(LaterMotion::Periodic(12, state)) =
            LaterMotion::of(&[0.3, 0.1], &[], 1.0, turning)
        else {
            panic!("it does not repeat itself")
        };
        assert!((state[0].hypot(state[1]) - 1.0).abs() < 1e-6);
    }

    /// An angle that comes to grow by a turn in two periods goes round.
    #[test]
    fn a_rotation_is_told_by_its_turns() {
        let rotating = |state: &[f64]| {
            let end = vec![state[0] - PI, 1.0 + 0.5 * (state[1] - 1.0)];
            Some(PeriodSamples { positions: vec![state[0]; SAMPLES], end })
        };
        let found = LaterMotion::of(&[0.3, 0.2], &[0], 1.0, rotating);
        let Some(LaterMotion::Aperiodic(found)) = found else { panic!("it repeats itself") };
        let expected = RotatingMotion { turns: -1, in_periods: 2 };
        assert_eq!(found, AperiodicMotion::Rotating(expected));
    }
}

//! Guesses of motions of every size near free ones: those whose period fits the drive, at the phases
//! at which the drive gives as much energy in a period as the damping takes.
//!
//! ```text
//! x_0(t; E) free, without damping and drive, T_0(E) = T/k:    M(tau) = integral_0^T f(x_0, x_0', omega (t - tau)) x_0' dt = 0
//! ```
//!
//! M is Melnikov's function of subharmonic motions (J. Guckenheimer and P. Holmes, *Nonlinear
//! Oscillations, Dynamical Systems, and Bifurcations of Vector Fields*, Springer 1983, section 4.6);
//! the restoring force adds nothing to it. A motion against a stiff stop is far from a single
//! harmonic, but near a free one. In: the equation, the free motions, an equilibrium and a value of
//! the parameter. Out: starts from which shooting is to find a motion. Costs some sixty free
//! motions, and some thousand evaluations of the force for each that fits.

use std::f64::consts::TAU;

use super::driven::Driven;
use super::free_swing::FreeSwings;
use crate::numeric::ode::root::find_root;

/// Number of free motions in a decade of amplitudes, and decades below and above the size of the
/// motions that are known.
const EACH_DECADE: i32 = 10;
const BELOW: i32 = 1;
const ABOVE: i32 = 2;

/// Number of points of a free motion, and of values of tau.
const SAMPLES: usize = 64;

/// The start of a guess, and the amplitude of its free motion.
pub(super) type GuessedStart = ([f64; 2], f64);

/// Starts near free motions about an equilibrium that swing up to `most` times in a period; `size` is
/// that of the motions that are known.
pub(super) fn guesses(
    driven: &Driven,
    swings: &FreeSwings,
    (place, parameter): (f64, f64),
    most: usize,
    size: f64,
) -> Vec<GuessedStart> {
    let omega = driven.frequency_at(parameter);
    let amplitude = |step: i32| size * 10_f64.powf(f64::from(step) / f64::from(EACH_DECADE));
    let frequency =
        |amplitude: f64| Some(swings.half_period(place - amplitude)?.recip() * 0.5 * TAU);
    let steps = -BELOW * EACH_DECADE..=ABOVE * EACH_DECADE;
    let known = steps.filter_map(|step| Some([amplitude(step), frequency(amplitude(step))?]));
    let known: Vec<[f64; 2]> = known.collect();
    let mut found = Vec::new();
    for number in 1..=most {
        let fits = number as f64 * omega;
        let between = known.windows(2).filter(|pair| {
            let [one, other] = [pair[0][1] - fits, pair[1][1] - fits];
            one * other <= 0.0
        });
        for pair in between {
            let missed = |amplitude: f64| frequency(amplitude).unwrap_or(f64::NAN) - fits;
            let Ok(amplitude) = find_root(missed, pair[0][0], pair[1][0]) else { continue };
            let Some(orbit) = swings.orbit(place - amplitude, SAMPLES) else { continue };
            let starts = starts_on(driven, &orbit, (number, omega), parameter);
            found.extend(starts.into_iter().map(|start| (start, amplitude)));
        }
    }
    found
}

/// The points of a free motion at which it is to begin at phase zero so that M vanishes.
fn starts_on(
    driven: &Driven,
    orbit: &[[f64; 2]],
    (number, omega): (usize, f64),
    parameter: f64,
) -> Vec<[f64; 2]> {
    let count = orbit.len();
    let step = TAU / (omega * (number * count) as f64);
    let melnikov = |begins: usize| -> f64 {
        let power = |sample: usize| {
            let [x, v] = orbit[(begins + sample) % count];
            driven.force(&[x, v, omega * step * sample as f64, parameter]) * v
        };
        (0..number * count).map(power).sum()
    };
    let values: Vec<f64> = (0..count).map(melnikov).collect();
    let changes = (0..count).filter(|index| values[*index] * values[(index + 1) % count] <= 0.0);
    let start = |index: usize| {
        let (one, other) = (values[index], values[(index + 1) % count]);
        let part = if one == other { 0.5 } else { one / (one - other) };
        let [from, to] = [orbit[index], orbit[(index + 1) % count]];
        [0, 1].map(|i| from[i] + part * (to[i] - from[i]))
    };
    changes.map(start).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::backbone::free_oscillator;
    use crate::response::stability::{MotionGuess, periodic_motion};
    use crate::response::{PreparedRequest, ResponseRequest};

    /// With little damping and a small drive two motions, one of them stable, are near a free motion
    /// of the same period, the nearer the smaller both are.
    #[test]
    fn guesses_are_near_the_motions() {
        let mut apart = Vec::new();
        for [c, drive] in
            ["1/100", "1/1000"].into_iter().zip(["3/50", "3/500"]).map(|(c, f)| [c, f])
        {
            let equation =
                format!("x'' + {c}*x' + x + 50*max(x - 1/2, 0)^(3/2) = {drive}*cos(w*t)");
            let question = ResponseRequest::new(&equation, "w", [1.0, 2.0], "").expect("a request");
            let asked =
                PreparedRequest::new(&question, question.equations.oscillator().expect("one"))
                    .expect("a request");
            let free = free_oscillator(&asked.oscillator).expect("an oscillator");
            let swings = FreeSwings::at(&free, (question.parameter, 1.4)).expect("series");
            let found = guesses(&asked.driven, &swings, (0.0, 1.4), 1, 0.5);
            assert_eq!(found.len(), 2, "{found:?}");
            let mut stable = 0;
            let mut farthest = 0.0_f64;
            for (start, size) in found {
                let guess = MotionGuess { start, parameter: 1.4, size };
                let truth = periodic_motion(&asked.driven, guess).expect("a motion");
                stable += usize::from(truth.floquet.largest() < 1.0);
                let [x, v] = truth.start;
                farthest = farthest.max((x - start[0]).hypot(v - start[1]) / size);
            }
            assert_eq!(stable, 1);
            apart.push(farthest);
        }
        assert!(apart[0] < 0.15 && apart[1] < 0.3 * apart[0], "{apart:?}");
    }
}

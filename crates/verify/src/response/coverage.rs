//! The distances between the values of the parameter at which a search for motions begins.
//!
//! ```text
//! f(x_s, 0, theta; p) = 0:   x_s the outermost place at which the force vanishes in a phase of the drive
//! n(p) = sqrt(<abs(f_x(x_s))>)/Omega:   free swings in a period of the drive, in the stiffness there
//! ```
//!
//! A whole resonance lies between two neighbouring values between which n grows by one, with
//! branches of its own: of `x'' + x + x^3 = F cos(2 t)` with F up to 1e6 n grows to sixty. In: the
//! equation, its range, and the values of a search. Out: more values, one swing apart, from the fewest
//! swings on; and the stretches of the range in which they are still farther apart, which are left out of
//! the response: harmonics would not suffice for so many swings either. Linear forces, and
//! drives of which only the frequency varies, have the same stiffness everywhere and no such stretch.

use std::f64::consts::TAU;

use super::PreparedRequest;
use super::driven::Driven;
use crate::numeric::ode::root::find_root;

/// The largest number of swings by which neighbouring values may differ.
const SWING: f64 = 1.0;

/// The values that a search takes besides its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Coverage {
    /// The values that were added.
    pub(super) added: Vec<f64>,
    /// The stretches of the range in which neighbouring values are more than a swing apart.
    pub(super) gaps: Vec<[f64; 2]>,
    /// The value at which the swings are fewest.
    slowest: f64,
}

impl Coverage {
    /// The stretch without gaps about the value at which the swings are fewest; `None` without gaps, or
    /// if there is no such stretch.
    pub(super) fn covered(&self, [low, high]: [f64; 2]) -> Option<[f64; 2]> {
        let ends = self.gaps.iter().map(|gap| gap[1]).filter(|end| *end <= self.slowest);
        let begins = self.gaps.iter().map(|gap| gap[0]).filter(|begin| *begin >= self.slowest);
        let [from, to] = [ends.fold(low, f64::max), begins.fold(high, f64::min)];
        (!self.gaps.is_empty() && from < to).then_some([from, to])
    }
}

impl PreparedRequest<'_> {
    /// The values that are to be added to these, and the stretches that stay sparse.
    pub(super) fn coverage(&self, values: &[f64]) -> Coverage {
        /// Largest number of values that are added.
        const MOST: usize = 24;
        if self.driven.self_excited || self.driven.jumps() > 0 {
            return Coverage::default();
        }
        let [low, high] = self.question.range;
        let mut values: Vec<f64> = values.iter().copied().chain([low, high]).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let swings = |parameter: f64| swings(&self.driven, parameter).unwrap_or(f64::NAN);
        let mut known: Vec<[f64; 2]> = values.into_iter().map(|p| [p, swings(p)]).collect();
        let countable = known.iter().filter(|point| !point[1].is_nan());
        let slowest = countable.min_by(|one, other| one[1].total_cmp(&other[1]));
        let slowest = slowest.map_or(low, |point| point[0]);
        let mut added = Vec::new();
        while added.len() < MOST {
            let wide = known.windows(2).enumerate().filter(|(_, pair)| is_wide(pair));
            let fewest = |pair: &[[f64; 2]]| pair[0][1].min(pair[1][1]);
            let first = wide.min_by(|(_, one), (_, two)| fewest(one).total_cmp(&fewest(two)));
            let Some((index, pair)) = first else { break };
            // One swing more than at the end with fewer of them.
            let wanted = fewest(pair) + 0.95 * SWING;
            let [from, to] = [pair[0][0], pair[1][0]];
            let Ok(value) = find_root(|p| swings(p) - wanted, from, to) else { break };
            if value <= from || value >= to {
                break;
            }
            known.insert(index + 1, [value, swings(value)]);
            added.push(value);
        }
        let mut gaps: Vec<[f64; 2]> = Vec::new();
        for pair in known.windows(2).filter(|pair| is_wide(pair)) {
            match gaps.last_mut() {
                Some(last) if last[1] == pair[0][0] => last[1] = pair[1][0],
                _ => gaps.push([pair[0][0], pair[1][0]]),
            }
        }
        Coverage { added, gaps, slowest }
    }
}

/// Whether two values with their swings are too far apart.
fn is_wide(pair: &[[f64; 2]]) -> bool {
    (pair[1][1] - pair[0][1]).abs() > SWING
}

/// The free swings in a period of the drive, in the stiffness at the outermost places where the force
/// vanishes; `None` if it vanishes nowhere, or has no value on the way.
fn swings(driven: &Driven, parameter: f64) -> Option<f64> {
    const PHASES: usize = 16;
    let force = |x: f64, theta: f64| driven.force(&[x, 0.0, theta, parameter]);
    let theta = |phase: usize| TAU * (phase as f64 + 0.5) / PHASES as f64 * driven.periods as f64;
    let at_places = |theta: f64| -> Vec<[f64; 2]> {
        places().map(|place| [force(place, theta), force(-place, theta)]).collect()
    };
    // A drive that does not depend on the place moves all forces at once.
    let first = driven.drive_is_added().then(|| at_places(theta(0)));
    let mut sum = 0.0;
    for phase in 0..PHASES {
        let theta_here = theta(phase);
        let drive = force(0.0, theta_here) - force(0.0, theta(0));
        let forces = match &first {
            Some(first) if drive.is_finite() => {
                first.iter().map(|pair| pair.map(|force| force + drive)).collect()
            }
            _ => at_places(theta_here),
        };
        let place = outermost_zero(&forces, |x| force(x, theta_here))?;
        sum += driven.slopes(&[place, 0.0, theta_here, parameter])[0].abs() / PHASES as f64;
    }
    let drive = driven.frequency_at(parameter) * driven.periods as f64;
    let swings = sum.sqrt() / drive;
    swings.is_finite().then_some(swings)
}

/// The places at which a zero is looked for, on either side, from the farthest on.
fn places() -> impl Iterator<Item = f64> {
    const FARTHEST: f64 = 1e8;
    const NEAREST: f64 = 1e-8;
    const RATIO: f64 = 1.25;
    let inner = |place: &f64| (*place > NEAREST).then_some(place / RATIO);
    std::iter::successors(Some(FARTHEST), inner)
}

/// The zero of a function that is farthest from zero, from its values at the [`places`] on either side;
/// `None` if there is none.
fn outermost_zero(values: &[[f64; 2]], function: impl Fn(f64) -> f64) -> Option<f64> {
    let mut signs = *values.first()?;
    let places: Vec<f64> = places().collect();
    for (pair, here) in places.windows(2).zip(&values[1..]) {
        for (side, (sign, here)) in [1.0, -1.0].into_iter().zip(signs.iter_mut().zip(here)) {
            if !here.is_finite() {
                return None;
            }
            if here * *sign <= 0.0 && sign.is_finite() {
                return find_root(&function, side * pair[1], side * pair[0]).ok();
            }
            *sign = *here;
        }
    }
    (signs[0] * signs[1] <= 0.0).then_some(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::ResponseRequest;

    fn coverage(equation: &str, parameter: &str, range: [f64; 2], values: &[f64]) -> Coverage {
        let question = ResponseRequest::new(equation, parameter, range, "").expect("a request");
        let asked = PreparedRequest::new(&question, question.equations.oscillator().expect("one"))
            .expect("a request");
        asked.coverage(values)
    }

    /// A drive over six decades takes the cubic spring from half a swing in a period to seventy: by hand,
    /// x_s = cbrt(F cos theta) far out, n = sqrt(3 <x_s^2>)/2.
    #[test]
    fn a_strong_drive_has_gaps_and_a_weak_one_has_none() {
        let equation = "x'' + x'/10 + x + x^3 = F*cos(2*t)";
        let steps: Vec<f64> = (0..=20).map(|step| f64::from(step) * 5e4).collect();
        let Coverage { added, gaps, .. } = coverage(equation, "F", [0.0, 1e6], &steps);
        assert!(added.iter().any(|value| *value < 10.0) && added.len() == 24, "{added:?}");
        assert!(gaps.len() == 1 && gaps[0][0] > 1e3 && gaps[0][1] == 1e6, "{gaps:?}");
        let driven = ResponseRequest::new(equation, "F", [0.0, 1e6], "").expect("a request");
        let asked = PreparedRequest::new(&driven, driven.equations.oscillator().expect("one"))
            .expect("a request");
        // The mean of abs(cos)^(2/3) is Gamma(5/6)/(sqrt(pi) Gamma(4/3)) = 0.7131.
        let covered = Coverage { added, gaps: gaps.clone(), slowest: 0.0 }.covered([0.0, 1e6]);
        assert_eq!(covered, Some([0.0, gaps[0][0]]));
        let by_hand = (3.0 * 1e4 * 0.7131_f64).sqrt() / 2.0;
        let found = swings(&asked.driven, 1e6).expect("swings");
        assert!((found / by_hand - 1.0).abs() < 0.01, "{found} {by_hand}");
        let weak = coverage(equation, "F", [0.0, 1.0], &[0.25, 0.5, 0.75]);
        assert!(weak.added.is_empty() && weak.gaps.is_empty(), "{weak:?}");
    }

    /// The stiffness of a linear force is the same at every value, and so is that of a drive whose
    /// frequency varies.
    #[test]
    fn a_linear_force_has_no_gap() {
        for (equation, parameter) in [
            ("x'' + x'/10 + x = F*cos(2*t)", "F"),
            ("x'' + x'/10 + x + x^3 = 10*cos(2*t) - F*x'", "F"),
            ("x'' + x'/10 + sin(x) = F*cos(2*t)", "F"),
        ] {
            let found = coverage(equation, parameter, [0.0, 1e6], &[]);
            assert!(found.added.is_empty() && found.gaps.is_empty(), "{found:?}");
        }
    }
}

//! The branch of a relation between frequency and amplitude that starts at the linear frequency,
//! followed in the amplitude.
//!
//! References: E. L. Allgower, K. Georg, *Introduction to Numerical Continuation Methods*, SIAM
//! 2003, chapter 2 (prediction along the tangent, correction by Newton's iteration); S.
//! Smale, *Newton's method estimates from data at one point*, 1986 (how far other roots are, from the
//! derivatives at one root).
//!
//! ```text
//! F(z, A) = sum_i c_i A^(p_i) z^(q_i) = 0,   z = omega^2,   d ln z/d ln A = - sum p_i c_i A^(p_i) z^(q_i) / sum q_i c_i A^(p_i) z^(q_i)
//! at small A:  z = w A^m, m the least p/(n - q) over all terms, n the highest power of z; m = 0 and w = omega0^2 where the
//!              force has a linear part; of several roots w the largest
//! no other root of F = sum_k b_k (u - 1)^k within 1/(2 gamma) of u = 1,   gamma = max_k |b_k/b_1|^(1/(k - 1))
//! ```
//!
//! If omega^2 is negative at small amplitudes, about an unstable equilibrium that the motions pass,
//! there is no branch from rest. The root is then followed at one amplitude from that of the first
//! order, by a homotopy in d that turns the higher orders on:
//!
//! ```text
//! F(z, d) = c_n z^n + c_(n-1) z^(n-1) + d c_(n-2) z^(n-2) + d^2 c_(n-3) z^(n-3) + ... = 0,   d = 0 ... 1
//! ```
//!
//! Steps are taken in `ln A`, and a step counts only where the correction is small beside the
//! distance to all other roots, at its end and, along the tangent there, back at its beginning: a
//! prediction alone may fall beside another root by chance. Mantissa and binary exponent are kept
//! apart ([`Scaled`]): at order 20 the terms span far more than the range of doubles.

use crate::exact::scaled::Scaled;

/// A term `coefficient A^amplitude z^frequency`.
pub(super) struct BranchTerm {
    pub(super) coefficient: Scaled,
    pub(super) amplitude: i32,
    pub(super) frequency: i32,
}

/// The branch at an amplitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Branch {
    /// omega^2 there, and how far the rounding of the coefficients may move it, relatively.
    At {
        /// omega^2.
        squared: f64,
        /// Its relative rounding error.
        rounding: f64,
    },
    /// The branch goes no farther than this amplitude: it turns back there, or its frequency
    /// reaches zero.
    Ends(f64),
    /// Rest is unstable, and no positive root at this amplitude continues that of the first order.
    NoneOfFirstOrder,
}

/// Follows the branch from rest to `amplitude`, with coefficients good to `precision`, relatively;
/// `None` if it has no start, or a value is not finite.
pub(super) fn follow(terms: &[BranchTerm], amplitude: f64, precision: f64) -> Option<Branch> {
    if terms.iter().any(|term| !term.coefficient.mantissa.is_finite()) || !amplitude.is_finite() {
        return None;
    }
    if rest_is_unstable(terms) {
        let highest = terms.iter().map(|term| term.frequency).max()?;
        let size = Scaled::new(amplitude);
        let graded = |term: &BranchTerm| BranchTerm {
            coefficient: term.coefficient.product(size.power(term.amplitude)),
            amplitude: i32::max(highest - 1 - term.frequency, 0),
            frequency: term.frequency,
        };
        let graded: Vec<BranchTerm> = terms.iter().map(graded).collect();
        return Some(match follow_up(&graded, 1.0, precision) {
            Some(found @ Branch::At { .. }) => found,
            _ => Branch::NoneOfFirstOrder,
        });
    }
    follow_up(terms, amplitude, precision)
}

/// Whether omega^2 is negative at small amplitudes, about an unstable equilibrium that the motions
/// pass. In `z^n - (omega0^2 + c A^2 + ...) z^(n-1) + ...` the second coefficient is minus the
/// omega^2 of a motion of one term.
fn rest_is_unstable(terms: &[BranchTerm]) -> bool {
    let highest = terms.iter().map(|term| term.frequency).max().unwrap_or(0);
    let lowest = |frequency: i32| {
        let terms = || {
            let used = terms.iter().filter(|term| term.coefficient.mantissa != 0.0);
            used.filter(move |term| term.frequency == frequency)
        };
        let power = terms().map(|term| term.amplitude).min()?;
        let values: Vec<Scaled> =
            terms().filter(|term| term.amplitude == power).map(|term| term.coefficient).collect();
        let unit = values.iter().map(|value| value.exponent).max()?;
        Some(values.iter().map(|value| value.in_units(unit)).sum::<f64>())
    };
    let signs = lowest(highest).zip(lowest(highest - 1));
    signs.is_some_and(|(first, second)| first * second > 0.0)
}

/// Does the work of [`follow`] if the branch starts at small amplitudes.
fn follow_up(terms: &[BranchTerm], amplitude: f64, precision: f64) -> Option<Branch> {
    const LONGEST: f64 = 0.5;
    const SHORTEST: f64 = 1e-11;
    if !amplitude.is_finite() {
        return None;
    }
    let relation =
        FrequencyRelation { highest: terms.iter().map(|term| term.frequency).max()?, terms };
    let target = Scaled::new(amplitude);
    let (mut at, mut z) = relation.start(target)?;
    let (mut length, goal) = (LONGEST / 8.0, target.logarithm());
    while at.logarithm() < goal {
        let left = goal - at.logarithm();
        let step = f64::min(length, left);
        let next = if step == left { target } else { at.product(Scaled::new(step.exp())) };
        let onward = relation
            .extrapolated(at, z, step)
            .and_then(|predicted| relation.corrected(next, predicted));
        let returns = |found: &Scaled| {
            let back = relation.extrapolated(next, *found, -step);
            back.is_some_and(|back| relation.is_near(at, back, z))
        };
        match onward.filter(returns) {
            Some(found) => {
                (at, z) = (next, found);
                if step == left {
                    break;
                }
                length = f64::min(2.0 * length, LONGEST);
            }
            None => length = 0.5 * step,
        }
        if length < SHORTEST {
            return Some(Branch::Ends(at.in_units(0)));
        }
    }
    let squared = z.in_units(0);
    let rounding = relation.rounding(target, z, precision);
    (squared.is_finite() && rounding.is_finite()).then_some(Branch::At { squared, rounding })
}

struct FrequencyRelation<'a> {
    terms: &'a [BranchTerm],
    highest: i32,
}

impl FrequencyRelation<'_> {
    /// The coefficient of `u^q` in every term at an amplitude, with `z = u 2^k`, all in one unit in
    /// which the largest is of order one.
    fn values(&self, amplitude: Scaled, k: i64) -> Vec<f64> {
        let value = |term: &BranchTerm| {
            let value = term.coefficient.product(amplitude.power(term.amplitude));
            Scaled { exponent: value.exponent + k * i64::from(term.frequency), ..value }
        };
        let values: Vec<Scaled> = self.terms.iter().map(value).collect();
        let sizes = values.iter().filter(|value| value.mantissa != 0.0);
        let unit = sizes.map(|value| value.exponent).max().unwrap_or(0);
        values.iter().map(|value| value.in_units(unit)).collect()
    }

    /// The polynomial in `u`, lowest power first.
    fn polynomial(&self, values: &[f64]) -> Vec<f64> {
        let mut coefficients =
            vec![0.0; usize::try_from(self.highest).map_or(0, |highest| highest + 1)];
        for (term, value) in self.terms.iter().zip(values) {
            if let Some(entry) =
                usize::try_from(term.frequency).ok().and_then(|q| coefficients.get_mut(q))
            {
                *entry += value;
            }
        }
        coefficients
    }

    /// An amplitude, not above the one asked for, at which the lowest terms alone decide, and the
    /// root there.
    fn start(&self, amplitude: Scaled) -> Option<(Scaled, Scaled)> {
        /// Relative size of all other terms together, so small that the isolation of the root by
        /// Rouche's theorem is kept.
        const SMALL: f64 = 1e-3;
        const HALVINGS: usize = 10_000;
        let exponent = |term: &BranchTerm| {
            let below = self.highest - term.frequency;
            (below > 0).then(|| f64::from(term.amplitude) / f64::from(below))
        };
        let used = self.terms.iter().filter(|term| term.coefficient.mantissa != 0.0);
        let growth = used.filter_map(exponent).fold(f64::INFINITY, f64::min);
        let decides = |term: &BranchTerm| match exponent(term) {
            Some(own) => own == growth,
            None => term.amplitude == 0,
        };
        let lowest: Vec<BranchTerm> = self
            .terms
            .iter()
            .filter(|term| decides(term))
            .map(|term| BranchTerm { ..*term })
            .collect();
        let lowest = FrequencyRelation { terms: &lowest, highest: self.highest };
        let mut at = amplitude;
        for _ in 0..HALVINGS {
            let z = lowest.largest_root(at)?;
            let values = self.values(at, z.exponent);
            let (mut leading, mut others) = (0.0, 0.0);
            for (term, value) in self.terms.iter().zip(&values) {
                let size = (value * z.mantissa.powi(term.frequency)).abs();
                if term.frequency == self.highest {
                    leading += size;
                }
                if !decides(term) {
                    others += size;
                }
            }
            if others <= SMALL * leading {
                let z = if others == 0.0 { z } else { self.newton(at, z)? };
                return Some((at, z));
            }
            at.exponent -= 1;
        }
        None
    }

    /// The largest root, by Newton's iteration from above all roots.
    fn largest_root(&self, amplitude: Scaled) -> Option<Scaled> {
        let size = |term: &BranchTerm| {
            let value = term.coefficient.product(amplitude.power(term.amplitude));
            value.logarithm()
        };
        let leading = self.terms.iter().find(|term| term.frequency == self.highest)?;
        let bound = self
            .terms
            .iter()
            .filter(|term| term.frequency < self.highest && term.coefficient.mantissa != 0.0)
            .map(|term| {
                let below = f64::from(self.highest - term.frequency);
                (size(term) - size(leading) + (self.terms.len() as f64).ln()) / below
            })
            .fold(f64::NEG_INFINITY, f64::max);
        if !bound.is_finite() {
            return None;
        }
        let start =
            Scaled { mantissa: 1.0, exponent: (bound / std::f64::consts::LN_2).ceil() as i64 + 1 };
        self.newton(amplitude, start)
    }

    /// The root that Newton's iteration reaches, where it is positive.
    fn newton(&self, amplitude: Scaled, start: Scaled) -> Option<Scaled> {
        const ITERATIONS: usize = 400;
        let polynomial = self.polynomial(&self.values(amplitude, start.exponent));
        let mut u = start.mantissa;
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let horner = |(value, slope): (f64, f64), coefficient: &f64| {
                (value * u + coefficient, slope * u + value)
            };
            let (value, slope) = polynomial.iter().rev().fold((0.0, 0.0), horner);
            if value == 0.0 {
                last = 0.0;
                break;
            }
            let change = value / slope;
            // Rounding may keep the last digits moving: they no longer shrink then.
            if !change.is_finite() || (change.abs() <= 1e-13 * u.abs() && change.abs() >= last) {
                break;
            }
            u -= change;
            last = change.abs();
        }
        let settled = last <= 1e-12 * u.abs();
        (settled && u > 0.0 && u.is_finite()).then(|| {
            let root = Scaled::new(u);
            Scaled { exponent: root.exponent + start.exponent, ..root }
        })
    }

    /// `d ln z/d ln A` along the branch.
    fn tangent(&self, amplitude: Scaled, z: Scaled) -> Option<f64> {
        let values = self.values(amplitude, z.exponent);
        let (mut above, mut below) = (0.0, 0.0);
        for (term, value) in self.terms.iter().zip(&values) {
            let value = value * z.mantissa.powi(term.frequency);
            above += f64::from(term.amplitude) * value;
            below += f64::from(term.frequency) * value;
        }
        Some(-above / below).filter(|slope| slope.is_finite())
    }

    /// Extrapolates the branch from a root along its tangent in `ln A` and `ln z`.
    fn extrapolated(&self, amplitude: Scaled, z: Scaled, step: f64) -> Option<Scaled> {
        let slope = self.tangent(amplitude, z)?;
        Some(z.product(Scaled::new((slope * step).exp())))
    }

    /// The root nearest to a prediction, if it is much closer to the prediction than to any other
    /// root; `None` otherwise.
    fn corrected(&self, amplitude: Scaled, predicted: Scaled) -> Option<Scaled> {
        let root = self.newton(amplitude, predicted)?;
        self.is_near(amplitude, predicted, root).then_some(root)
    }

    /// Whether `place` is near `root`, compared with the distance from the root to any other.
    fn is_near(&self, amplitude: Scaled, place: Scaled, root: Scaled) -> bool {
        const SHARE: f64 = 0.2;
        let mut polynomial = self.polynomial(&self.values(amplitude, root.exponent));
        // Derivatives over factorials at the root, by repeated division, then in units of the root.
        let mut derivatives = Vec::with_capacity(polynomial.len());
        while let Some(highest) = polynomial.len().checked_sub(1) {
            for i in (0..highest).rev() {
                polynomial[i] += root.mantissa * polynomial[i + 1];
            }
            derivatives.push(polynomial.remove(0) * root.mantissa.powi(derivatives.len() as i32));
        }
        let Some(&slope) = derivatives.get(1) else {
            return false;
        };
        let gamma = derivatives
            .iter()
            .enumerate()
            .skip(2)
            .map(|(k, value)| (value / slope).abs().powf(1.0 / (k as f64 - 1.0)))
            .fold(0.0, f64::max);
        let way = (place.product(root.inverse()).in_units(0) - 1.0).abs();
        way <= SHARE * f64::min(0.5 / gamma, 1.0)
    }

    /// Relative change of a root if every term is changed by `precision` of itself.
    fn rounding(&self, amplitude: Scaled, z: Scaled, precision: f64) -> f64 {
        let values = self.values(amplitude, z.exponent);
        let (mut sizes, mut slope) = (0.0, 0.0);
        for (term, value) in self.terms.iter().zip(&values) {
            let value = value * z.mantissa.powi(term.frequency);
            sizes += value.abs();
            slope += f64::from(term.frequency) * value;
        }
        precision * sizes / slope.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `(z - 1 - s)(z - s/4)(z - s/9)` with `s = A^2`: the branch of the linear frequency is 1 + s,
    /// and the others pass close to what it was at smaller amplitudes.
    fn three_branches() -> Vec<BranchTerm> {
        let term = |coefficient: f64, amplitude, frequency| BranchTerm {
            coefficient: Scaled::new(coefficient),
            amplitude,
            frequency,
        };
        let (b, c) = (13.0 / 36.0, 1.0 / 36.0);
        vec![
            term(1.0, 0, 3),
            term(-1.0, 0, 2),
            term(-1.0 - b, 2, 2),
            term(b, 2, 1),
            term(b + c, 4, 1),
            term(-c, 4, 0),
            term(-c, 6, 0),
        ]
    }

    /// `z (z - s) + d q = 0` about an unstable rest, `s = A^2 (1 - A^2/20)^2 - 1`: motions between
    /// two separatrices and outside of a third have their own roots, each that of the first order
    /// as it is changed by `d`.
    #[test]
    fn the_branch_above_an_unstable_rest_continues_the_first_order() {
        let term = |coefficient: f64, amplitude, frequency| BranchTerm {
            coefficient: Scaled::new(coefficient),
            amplitude,
            frequency,
        };
        let terms = [
            term(1.0, 0, 2),
            term(1.0, 0, 1),
            term(-1.0, 2, 1),
            term(0.1, 4, 1),
            term(-0.0025, 6, 1),
            term(1e-3, 4, 0),
        ];
        for amplitude in [0.5, 1.05, 1.2, -2.0, 3.5, 4.47, 6.0, 1e3, 1e12] {
            let square = amplitude * amplitude;
            let first = square * (1.0 - square / 20.0) * (1.0 - square / 20.0) - 1.0;
            let under = first * first - 4e-3 * square * square;
            match follow(&terms, amplitude, f64::EPSILON) {
                Some(Branch::At { squared, .. }) => {
                    let expected = 0.5 * (first + under.sqrt());
                    assert!((squared / expected - 1.0).abs() < 1e-10, "{amplitude}");
                }
                Some(Branch::NoneOfFirstOrder) => {
                    assert!(first <= 0.0 || under <= 0.0, "{amplitude}")
                }
                other => panic!("{amplitude}: {other:?}"),
            }
        }
    }

    #[test]
    fn the_linear_branch_is_followed_past_others() {
        for power in -160..=150 {
            let amplitude = 10.0_f64.powi(power);
            let found = follow(&three_branches(), -amplitude, f64::EPSILON);
            let Some(Branch::At { squared: z, .. }) = found else {
                panic!("lost at {amplitude:e}: {found:?}");
            };
            let exact = 1.0 + amplitude * amplitude;
            assert!((z / exact - 1.0).abs() < 1e-12, "{amplitude}: {z} {exact}");
        }
    }

    #[test]
    fn the_end_of_a_branch_is_found() {
        // z^2 - z + A^2 = 0 turns back at A = 1/2.
        let term = |coefficient: f64, amplitude, frequency| BranchTerm {
            coefficient: Scaled::new(coefficient),
            amplitude,
            frequency,
        };
        let circle = [term(1.0, 0, 2), term(-1.0, 0, 1), term(1.0, 2, 0)];
        let found = follow(&circle, 0.49, f64::EPSILON);
        let upper = 0.5 + 0.0099_f64.sqrt();
        assert!(
            matches!(found, Some(Branch::At { squared, .. }) if (squared - upper).abs() < 1e-14),
            "{found:?} {upper}"
        );
        assert!(
            matches!(follow(&circle, 3.0, f64::EPSILON), Some(Branch::Ends(a)) if (a - 0.5).abs() < 1e-8)
        );
        assert!(
            matches!(follow(&circle, -3.0, f64::EPSILON), Some(Branch::Ends(a)) if (a + 0.5).abs() < 1e-8)
        );
    }

    #[test]
    fn a_bend_is_not_cut_short_onto_another_root() {
        // z^2 - 2 L z + L^2 - D/4 = 0 of order 2 for x - 1.9 x^3 + 1.17 x^5: the roots L +-
        // sqrt(D)/2 come close and part again.
        let l = |s: f64| 0.5 - 57.0 / 80.0 * s + 117.0 / 320.0 * s * s;
        let d = [1.0, -57.0 / 20.0, 2019.0 / 640.0, -24453.0 / 16000.0, 77571.0 / 256000.0];
        let term = |coefficient: f64, amplitude, frequency| BranchTerm {
            coefficient: Scaled::new(coefficient),
            amplitude,
            frequency,
        };
        let terms = [
            term(1.0, 0, 2),
            term(-1.0, 0, 1),
            term(57.0 / 40.0, 2, 1),
            term(-117.0 / 160.0, 4, 1),
            term(1083.0 / 12800.0, 4, 0),
            term(-2223.0 / 16000.0, 6, 0),
            term(59319.0 / 1024000.0, 8, 0),
        ];
        for k in 1..400 {
            let amplitude = 0.01 * f64::from(k);
            let s = amplitude * amplitude;
            let root = l(s) + 0.5 * d.iter().rev().fold(0.0, |sum, c| sum * s + c).sqrt();
            let found = follow(&terms, amplitude, f64::EPSILON);
            assert!(
                matches!(found, Some(Branch::At { squared, .. }) if (squared / root - 1.0).abs() < 1e-9),
                "{amplitude}: {found:?} {root}"
            );
        }
    }

    #[test]
    fn rounding_says_what_rounded_coefficients_leave() {
        // z - (1 - s + s^2/3) by its terms, s = A^2: the root itself, against coefficients changed
        // in the twelfth digit.
        let law = |factor: f64| {
            let term = |coefficient: f64, amplitude, frequency| BranchTerm {
                coefficient: Scaled::new(coefficient),
                amplitude,
                frequency,
            };
            [
                term(1.0, 0, 1),
                term(-1.0 - factor, 0, 0),
                term(1.0 - factor, 2, 0),
                term(-1.0 / 3.0 - factor, 4, 0),
            ]
        };
        let at = |factor| match follow(&law(factor), 1.2, 1e-12) {
            Some(Branch::At { squared, rounding }) => (squared, rounding),
            other => panic!("{other:?}"),
        };
        let ((exact, rounding), (changed, _)) = (at(0.0), at(1e-12));
        let moved = (changed / exact - 1.0).abs();
        assert!(moved < 5.0 * rounding && rounding < 100.0 * moved, "{moved} {rounding}");
    }
}

//! What stays constant along slow equations without damping and drive, and the period in which modes in
//! one resonance exchange their energy.
//!
//! ```text
//! a_j a_j' = C_j M sin gamma,   gamma' = G_0 + G_1 cos gamma,   M = prod a_j^(e_j)
//! Manley and Rowe:  C_k a_j^2 - C_j a_k^2 = constant,     d(a_j^2)/ds = 2 C_j
//! H = P + M cos gamma = constant,   dP/ds = G_0,  dM/ds = G_1
//! (ds/dt)^2 = M^2 - (H - P)^2 = f(s):   to and fro between two zeros of f,  T = 2 int ds/sqrt(f)
//! ```
//!
//! Where f is of third or fourth degree the integral is elliptic: `T` is a number times K(m) (P. F. Byrd,
//! M. D. Friedman, *Handbook of Elliptic Integrals*, Springer 1971, 233 to 260). Sources: J. M. Manley,
//! H. E. Rowe, *Proc. IRE* 44 (1956) 904; A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley
//! 1979, section 6.2.

use num_integer::Integer as _;
use num_traits::{One, Signed, Zero};

use super::SlowMotion;
use super::slow_equations::PhaseWaves;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::{Integer, ratio, to_f64};
use crate::exact::{Polynomial, Rational};
use crate::expr::{Expr, ExprError, Function};
use crate::numeric::ode::polynomial::real_zeros;
use crate::symbol::Symbol;

/// The constants of slow equations in which one slow phase alone occurs.
#[derive(Clone, Debug, PartialEq)]
pub struct SlowInvariants {
    /// The sums of Manley and Rowe: squares of amplitudes with their factors.
    pub sums: Vec<Polynomial>,
    /// H without its wave, and the factor of `cos gamma`; `None` if the rate of the phase does not
    /// follow from it.
    pub hamiltonian: Option<[Polynomial; 2]>,
    /// `C_j`, zero of a mode that does not take part.
    shares: Vec<Polynomial>,
    /// M.
    product: Monomial,
    /// `G_0`.
    drift: Polynomial,
}

/// The exchange of energy from given amplitudes and phases.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyExchange {
    /// The parameter m of K(m).
    pub parameter: f64,
    /// The period, `factor` times K(m).
    pub period: f64,
    /// The factor of K(m).
    pub factor: f64,
    /// The coefficients of f in `(ds/dt)^2 = f(s)`, the lowest first; s is zero at the start.
    pub rate_squared: Vec<f64>,
    /// The zeros of f between which s goes to and fro.
    pub ends: [f64; 2],
    /// The square of each amplitude, linear in s: its value at the start and its slope.
    pub squares: Vec<[f64; 2]>,
    /// The least and the greatest amplitude of each mode.
    pub amplitudes: Vec<[f64; 2]>,
}

impl SlowMotion {
    /// The constants of the slow motion; `None` if something damps or drives it, if no resonance acts
    /// or several do, or if the terms of this order have no such constants.
    ///
    /// ```
    /// # use lindstedt_modes as lindstedt;
    /// use lindstedt::expr::Expr;
    /// use lindstedt::multiple_scales::{CoupledSystem, MultipleScalesOptions, derive};
    ///
    /// let system = CoupledSystem::parse("x'' + x - 2*x*y/5 = 0; y'' + 4*y - 3*x^2/10 = 0")?;
    /// let slow = derive(&system, &MultipleScalesOptions::default())?;
    /// let constants = slow.invariants().expect("nothing damps it");
    /// assert_eq!(Expr::from(&constants.sums[0]).to_string(), "3*a1^2 + 8*a2^2");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn invariants(&self) -> Option<SlowInvariants> {
        let [(_, turns)] = self.slow_phases.as_slice() else { return None };
        let products: Vec<Polynomial> = self
            .rates
            .iter()
            .zip(&self.amplitudes)
            .map(|(rate, amplitude)| {
                Some(exchanged(&rate.amplitude)?.product(&Polynomial::symbol(*amplitude)))
            })
            .collect::<Option<_>>()?;
        let is_amplitude = |name: &Symbol| self.amplitudes.contains(name);
        let mut product: Option<Monomial> = None;
        let mut shares = Vec::new();
        for of_mode in &products {
            let mut share = Polynomial::zero();
            for (monomial, number) in of_mode.terms() {
                let (own, letters) = apart(monomial, &is_amplitude);
                if product.get_or_insert_with(|| own.clone()) != &own {
                    return None;
                }
                share.add_term(letters, number.clone());
            }
            shares.push(share);
        }
        let product = product?;
        let (drift, wave) = self.phase_rate(turns)?;
        let mut invariants =
            SlowInvariants { sums: vec![], hamiltonian: None, shares, product, drift };
        invariants.sums = invariants.manley_rowe(&self.amplitudes);
        invariants.hamiltonian = invariants.hamiltonian_of(&self.amplitudes, &wave);
        Some(invariants)
    }

    /// `gamma'`, without its wave and the factor of `cos gamma`; `None` if there are other waves.
    fn phase_rate(&self, turns: &[i32]) -> Option<(Polynomial, Polynomial)> {
        let (mut drift, mut wave) = (Polynomial::zero(), Polynomial::zero());
        for ((rate, amplitude), turn) in self.rates.iter().zip(&self.amplitudes).zip(turns) {
            if *turn == 0 {
                continue;
            }
            let over = Monomial::power_of(*amplitude, -1);
            let turn = ratio(i64::from(*turn), 1);
            for (own, [cosine, sine]) in &rate.phase {
                let part = cosine.times_monomial(&over).map(|number| number * &turn);
                match own.as_slice() {
                    [0] => drift.accumulate(&part),
                    [1] if sine.is_zero() => wave.accumulate(&part),
                    _ => return None,
                }
            }
        }
        Some((drift, wave))
    }
}

/// The factor of `sin gamma` in the rate of an amplitude; `None` if there is anything else.
fn exchanged(waves: &PhaseWaves) -> Option<Polynomial> {
    let mut found = Polynomial::zero();
    for (turns, [cosine, sine]) in waves {
        match turns.as_slice() {
            [1] if cosine.is_zero() => found = sine.clone(),
            _ => return None,
        }
    }
    Some(found)
}

/// The factors of a monomial that are amplitudes, and the others.
fn apart(monomial: &Monomial, is_amplitude: &dyn Fn(&Symbol) -> bool) -> (Monomial, Monomial) {
    let mut parts = (Monomial::one(), Monomial::one());
    for (name, exponent) in monomial.factors() {
        let part = if is_amplitude(name) { &mut parts.0 } else { &mut parts.1 };
        *part = part.product(&Monomial::power_of(*name, *exponent));
    }
    parts
}

/// A polynomial with whole coefficients without a common factor, the first positive.
fn primitive(polynomial: &Polynomial) -> Polynomial {
    let one = Integer::from(1);
    let numbers = || polynomial.terms().map(|(_, number)| number);
    let below = numbers().fold(one.clone(), |below, number| below.lcm(number.denom()));
    let above = numbers().fold(Integer::zero(), |above, number| {
        above.gcd(&(number * Rational::from_integer(below.clone())).to_integer())
    });
    let sign = match numbers().next().is_some_and(Signed::is_negative) {
        true => -one,
        false => one,
    };
    if above.is_zero() {
        return polynomial.clone();
    }
    let factor = Rational::new(below * sign, above);
    polynomial.map(|number| number * &factor)
}

/// A quotient of polynomials that is a single term.
fn ratio_of(above: &Polynomial, below: &Polynomial) -> Option<Polynomial> {
    let (top, number) = above.terms().next()?;
    let (bottom, scale) = below.terms().next()?;
    let ratio = Polynomial::term(top.product(&bottom.power(-1)), number / scale);
    (below.product(&ratio) == *above).then_some(ratio)
}

impl SlowInvariants {
    /// The constants as expressions, with the cosine of the slow phase where they have one.
    ///
    /// # Errors
    /// A step of algebra that fails.
    pub fn expressions(&self, slow_phase: Symbol) -> Result<Vec<Expr>, ExprError> {
        let mut all: Vec<Expr> = self.sums.iter().map(Expr::from).collect();
        if let Some([potential, wave]) = &self.hamiltonian {
            let cosine = Expr::function(Function::Cos, vec![Expr::from(slow_phase)])?;
            all.push(Expr::from(potential) + Expr::from(wave) * cosine);
        }
        Ok(all)
    }

    /// `C_k a_j^2 - C_j a_k^2` for the first mode that takes part and each other that does.
    fn manley_rowe(&self, amplitudes: &[Symbol]) -> Vec<Polynomial> {
        let mut part = (0..amplitudes.len()).filter(|mode| !self.shares[*mode].is_zero());
        let Some(first) = part.next() else { return vec![] };
        let squared = |share: &Polynomial, mode: usize| {
            share.times_monomial(&Monomial::power_of(amplitudes[mode], 2))
        };
        let sum = |other: usize| {
            let [own, others] = [&self.shares[first], &self.shares[other]];
            // Shares that differ by a factor have it alone in the sum.
            let [own, others] = match ratio_of(others, own) {
                Some(ratio) => [Polynomial::constant(Rational::one()), ratio],
                None => [own.clone(), others.clone()],
            };
            let mut sum = squared(&own, other);
            sum.negate();
            sum.accumulate(&squared(&others, first));
            primitive(&sum)
        };
        part.map(sum).collect()
    }

    /// `dM/ds` divided out: `sum e_j C_j M/a_j^2`.
    fn slope_of_product(&self, amplitudes: &[Symbol]) -> Polynomial {
        let mut slope = Polynomial::zero();
        for (amplitude, share) in amplitudes.iter().zip(&self.shares) {
            let exponent = ratio(i64::from(self.product.exponent(*amplitude)), 1);
            let over = self.product.product(&Monomial::power_of(*amplitude, -2));
            slope.accumulate(&share.times_monomial(&over).map(|number| number * &exponent));
        }
        slope
    }

    /// P and M, if `dM/ds` is the factor of the wave in the rate of the phase and `G_0` is a sum of
    /// powers of single amplitudes.
    fn hamiltonian_of(&self, amplitudes: &[Symbol], wave: &Polynomial) -> Option<[Polynomial; 2]> {
        let mut apart = self.slope_of_product(amplitudes);
        apart.negate();
        apart.accumulate(wave);
        if !apart.is_zero() {
            return None;
        }
        let first = (0..amplitudes.len()).find(|mode| !self.shares[*mode].is_zero())?;
        // A share of several terms multiplies the whole.
        let share = &self.shares[first];
        let factor = share.single_term().is_none().then(|| share.clone());
        let mut potential = Polynomial::zero();
        for (monomial, number) in self.drift.terms() {
            let own = (0..amplitudes.len())
                .filter(|mode| monomial.exponent(amplitudes[*mode]) != 0)
                .collect::<Vec<usize>>();
            let mode = match own.as_slice() {
                [] => first,
                [mode] if !self.shares[*mode].is_zero() => *mode,
                // The amplitude of a mode that takes no part is a constant.
                [mode] if self.shares[*mode].is_zero() => first,
                _ => return None,
            };
            // d(a^(k + 2))/ds = (k + 2) C a^k
            let power = monomial.exponent(amplitudes[mode]) + 2;
            let raised = monomial.product(&Monomial::power_of(amplitudes[mode], 2));
            let number = number / ratio(i64::from(power), 1);
            match (self.shares[mode].single_term(), &factor) {
                (Some((letters, scale)), None) => {
                    potential.add_term(raised.product(&letters.power(-1)), number / scale);
                }
                (_, Some(_)) if mode == first => potential.add_term(raised, number),
                _ => return None,
            }
        }
        let product = Polynomial::term(self.product.clone(), Rational::one());
        Some([potential, factor.map_or(product.clone(), |factor| factor.product(&product))])
    }

    /// The exchange from these amplitudes and slow phase, with a value for every letter; `None` if the
    /// integral is not elliptic, or the motion has no period.
    pub fn exchange(
        &self,
        amplitudes: &[(Symbol, f64)],
        phase: f64,
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Option<EnergyExchange> {
        let shares: Vec<f64> =
            self.shares.iter().map(|share| share.evaluate(value_of).ok()).collect::<Option<_>>()?;
        // a_j^2 as polynomials in s.
        let squares: Vec<Vec<f64>> = amplitudes
            .iter()
            .zip(&shares)
            .map(|((_, a), share)| vec![a * a, 2.0 * share])
            .collect();
        let power_of = |mode: usize, exponent: i32| -> Option<Vec<f64>> {
            let half = u32::try_from(exponent).ok().filter(|own| own % 2 == 0)? / 2;
            Some((0..half).fold(vec![1.0], |all, _| times(&all, &squares[mode])))
        };
        let exponents = |monomial: &Monomial| -> Vec<i32> {
            amplitudes.iter().map(|(name, _)| monomial.exponent(*name)).collect()
        };
        let mut drift = vec![0.0];
        for (monomial, number) in self.drift.terms() {
            let mut term = vec![to_f64(number)];
            for (mode, exponent) in exponents(monomial).into_iter().enumerate() {
                term = times(&term, &power_of(mode, exponent)?);
            }
            for (name, exponent) in monomial.factors() {
                if !amplitudes.iter().any(|(own, _)| own == name) {
                    let value = value_of(*name)?.powi(*exponent);
                    term.iter_mut().for_each(|own| *own *= value);
                }
            }
            drift = plus(&drift, &term);
        }
        let mut squared = vec![1.0];
        for (mode, exponent) in exponents(&self.product).into_iter().enumerate() {
            squared = times(&squared, &power_of(mode, 2 * exponent)?);
        }
        // H - P with P = 0 at the start, where M cos gamma is H.
        let start = squared[0].sqrt() * phase.cos();
        let potential = drift.iter().zip(1..).map(|(own, power)| -own / f64::from(power));
        let rest: Vec<f64> = std::iter::once(start).chain(potential).collect();
        let f = difference(&squared, &times(&rest, &rest));
        let Oscillation { ends, parameter, factor, period } = oscillation(&f)?;
        let range = |square: &Vec<f64>| {
            let mut own = ends.map(|s| square[0] + square[1] * s);
            own.sort_by(f64::total_cmp);
            // Rounding is what is left of a square that vanishes.
            let largest = own[1];
            own.map(|square| if square <= 1e-13 * largest { 0.0 } else { square.sqrt() })
        };
        let last = f.iter().rposition(|own| *own != 0.0)?;
        Some(EnergyExchange {
            parameter,
            period,
            factor,
            ends,
            amplitudes: squares.iter().map(range).collect(),
            squares: squares.iter().map(|square| [square[0], square[1]]).collect(),
            rate_squared: f.into_iter().take(last + 1).collect(),
        })
    }
}

/// The product of two polynomials, the lowest coefficient first.
fn times(one: &[f64], other: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; one.len() + other.len() - 1];
    for (i, a) in one.iter().enumerate() {
        for (j, b) in other.iter().enumerate() {
            product[i + j] += a * b;
        }
    }
    product
}

/// The sum of two polynomials.
fn plus(one: &[f64], other: &[f64]) -> Vec<f64> {
    let at = |of: &[f64], index: usize| of.get(index).copied().unwrap_or(0.0);
    (0..one.len().max(other.len())).map(|index| at(one, index) + at(other, index)).collect()
}

/// `one - other`, without what rounding leaves of coefficients that cancel.
fn difference(one: &[f64], other: &[f64]) -> Vec<f64> {
    const ROUNDING: f64 = 1e-13;
    let at = |of: &[f64], index: usize| of.get(index).copied().unwrap_or(0.0);
    let entry = |index: usize| {
        let (own, taken) = (at(one, index), at(other, index));
        let rest = own - taken;
        if rest.abs() <= ROUNDING * (own.abs() + taken.abs()) { 0.0 } else { rest }
    };
    (0..one.len().max(other.len())).map(entry).collect()
}

/// The motion `(ds/dt)^2 = f(s)` from s = 0.
struct Oscillation {
    ends: [f64; 2],
    parameter: f64,
    factor: f64,
    period: f64,
}

/// The oscillation of a polynomial of second to fourth degree about s = 0; `None` if s does not turn on
/// both sides, or rests.
fn oscillation(f: &[f64]) -> Option<Oscillation> {
    /// Distance of two zeros, as a part of the largest, below which they are one: there s needs for ever.
    const SAME: f64 = 1e-9;
    let length = f.iter().rposition(|own| *own != 0.0)? + 1;
    let f = &f[..length];
    let degree = f.len().checked_sub(1)?;
    if !(2..=4).contains(&degree) {
        return None;
    }
    let leading = f[degree];
    let zeros: Vec<f64> = real_zeros(f, [f64::NEG_INFINITY, f64::INFINITY])
        .into_iter()
        .map(|zero| zero.place)
        .collect();
    let far = zeros.iter().map(|zero| zero.abs()).fold(0.0, f64::max);
    // The start may itself be an end.
    let value = |s: f64| f.iter().rev().fold(0.0, |sum, own| sum * s + own);
    let between = zeros.windows(2).find(|pair| {
        let inside = pair[0] <= SAME * far && pair[1] >= -SAME * far;
        inside && value(0.5 * (pair[0] + pair[1])) > 0.0
    })?;
    let ends = [between[0], between[1]];
    if zeros.windows(2).any(|pair| pair[1] - pair[0] <= SAME * far) {
        return None;
    }
    let elliptic = |parameter: f64| -> Option<f64> {
        let parameter = crate::exact::rational::from_f64(parameter)?;
        let k = Expr::function(Function::EllipticK, vec![Expr::number(parameter)]).ok()?;
        k.evaluate(&std::collections::BTreeMap::new()).ok()
    };
    let [b, a] = ends;
    let others: Vec<f64> = zeros.iter().copied().filter(|zero| *zero != a && *zero != b).collect();
    let (parameter, product) = match (degree, others.as_slice()) {
        // A harmonic oscillation.
        (2, []) => (0.0, 1.0),
        (3, [c]) => {
            let distance = if leading < 0.0 { a - c } else { c - b };
            ((a - b) / distance, distance)
        }
        (4, [c, d]) => {
            // (u - c)(u - d) has one sign between the ends; the cross ratio of all four decides.
            let [low, high] = [c.min(*d), c.max(*d)];
            if high <= b || low >= a {
                // Both on one side.
                let (near, away) = if high <= b { (high, low) } else { (low, high) };
                let (end, other) = if high <= b { (a, b) } else { (b, a) };
                let product = (end - near) * (other - away);
                ((end - other) * (near - away) / product, product)
            } else {
                let product = (high - b) * (a - low);
                ((a - b) * (high - low) / product, product)
            }
        }
        (4, []) => {
            // f = leading (s - a)(s - b)(s^2 + p s + q)
            let p = f[3] / leading + a + b;
            let q = f[2] / leading - a * b + p * (a + b);
            let (center, width) = (-0.5 * p, q - 0.25 * p * p);
            let distance = |end: f64| ((end - center).powi(2) + width).sqrt();
            let product = distance(a) * distance(b);
            let parameter =
                ((a - b).powi(2) - (distance(a) - distance(b)).powi(2)) / (4.0 * product);
            (parameter, product)
        }
        _ => return None,
    };
    let factor = 4.0 / (leading * product).abs().sqrt();
    Some(Oscillation { ends, parameter, factor, period: factor * elliptic(parameter)? })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// The period is the integral of ds/sqrt(f), by Gauss and Chebyshev, for zeros in every position.
    #[test]
    fn periods_are_those_of_the_integral() {
        let product = |zeros: &[f64], leading: f64| {
            zeros.iter().fold(vec![leading], |all, zero| times(&all, &[-zero, 1.0]))
        };
        let pair = times(&product(&[-0.7, 1.2], -0.9), &[2.0, 0.6, 1.0]);
        let cases = [
            product(&[-0.7, 1.2], -2.0),
            product(&[-3.0, -0.7, 1.2], -2.0),
            product(&[-0.7, 1.2, 2.9], 1.5),
            product(&[-4.0, -3.0, -0.7, 1.2], -0.3),
            product(&[-0.7, 1.2, 2.0, 5.0], -0.3),
            product(&[-3.0, -0.7, 1.2, 1.9], 0.4),
            pair,
        ];
        for f in cases {
            let found = oscillation(&f).expect("it turns on both sides");
            let [b, a] = found.ends;
            assert!((b + 0.7).abs() < 1e-12 && (a - 1.2).abs() < 1e-12, "{f:?}");
            // ds/sqrt((a - s)(s - b) g) with s = (a + b)/2 + (a - b)/2 cos: the mean of 1/sqrt(g).
            let count = 400;
            let sum: f64 = (0..count)
                .map(|k| {
                    let angle = PI * (f64::from(k) + 0.5) / f64::from(count);
                    let s = 0.5 * (a + b) + 0.5 * (a - b) * angle.cos();
                    let value = f.iter().rev().fold(0.0, |sum, own| sum * s + own);
                    1.0 / (value / ((a - s) * (s - b))).sqrt()
                })
                .sum();
            let period = 2.0 * PI * sum / f64::from(count);
            assert!(
                (found.period / period - 1.0).abs() < 1e-10,
                "{f:?}: {} {period}",
                found.period
            );
        }
        // Two zeros in one place: s comes there after an infinite time.
        assert!(oscillation(&product(&[-3.0, -3.0, -0.7, 1.2], -1.0)).is_none());
        assert!(oscillation(&product(&[-0.7, 1.2, 1.2], 1.0)).is_none());
    }
}

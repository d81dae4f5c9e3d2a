//! The convergence-control parameter of homotopy analysis in numbers: the hbar with the least
//! squared residual.
//!
//! Reference: S. Liao, Commun. Nonlinear Sci. Numer. Simul. 15 (2010) 2003-2016.
//!
//! ```text
//! E(hbar) = sum_j [omega^2 x''(theta_j) + f(x(theta_j))]^2,   omega = omega(hbar),   x = sum_k a_k(hbar) cos(k theta)
//! ```
//!
//! At given numbers omega and all a_k are polynomials in hbar alone. Their terms are evaluated once
//! for each amplitude, their fractions become doubles once for all amplitudes, and a trial of hbar
//! costs little more than the samples of the force.

use std::collections::BTreeMap;

use crate::conservative::force::CentredForce;
use crate::exact::{Monomial, Polynomial, Rational, Scaled};
use crate::numeric::ode::root::find_minimum;
use crate::solution::Solution;
use crate::symbol::Symbol;

/// Number of samples over half a period.
const SAMPLES: usize = 64;

/// A function of theta at the samples.
type Samples = [f64; SAMPLES];

/// Law and harmonics of a formula with their fractions as floating-point numbers.
pub(super) struct FormulaInHbar {
    /// Every power of a symbol that occurs.
    powers: Vec<(Symbol, i32)>,
    frequency: Vec<TermInHbar>,
    /// Number of each harmonic, cosine and sine.
    harmonics: Vec<(usize, [Vec<TermInHbar>; 2])>,
    /// `cos(k theta)` and `sin(k theta)` at the samples, for each harmonic.
    waves: Vec<[Samples; 2]>,
}

/// The hbar of least residual, and omega by the formula there.
#[derive(Clone, Copy, Debug)]
pub(super) struct LeastResidual {
    pub(super) hbar: f64,
    pub(super) frequency: f64,
}

/// A coefficient, the power of hbar, and the indices of the other powers.
struct TermInHbar {
    coefficient: Scaled,
    hbar: usize,
    factors: Vec<usize>,
}

impl FormulaInHbar {
    /// The law and the motion of an answer; `None` if the law does not give omega, or has negative
    /// powers of hbar.
    pub(super) fn new(solution: &Solution, hbar: Symbol) -> Option<Self> {
        let mut places: BTreeMap<(Symbol, i32), usize> = BTreeMap::new();
        let mut converted = |polynomial: &Polynomial| {
            let term = |(monomial, number): (&Monomial, &Rational)| {
                let factors = monomial.factors().iter().copied();
                let (own, others): (Vec<_>, Vec<_>) = factors.partition(|factor| factor.0 == hbar);
                let place = |factor| {
                    let next = places.len();
                    *places.entry(factor).or_insert(next)
                };
                Some(TermInHbar {
                    coefficient: Scaled::of_fraction(number),
                    hbar: usize::try_from(own.first().map_or(0, |factor| factor.1)).ok()?,
                    factors: others.into_iter().map(place).collect(),
                })
            };
            polynomial.terms().map(term).collect::<Option<Vec<_>>>()
        };
        let frequency = converted(solution.law.frequency()?)?;
        let harmonics = solution.displacement.harmonics().into_iter();
        let harmonics = harmonics
            .map(|(k, cosine, sine)| Some((k, [converted(&cosine)?, converted(&sine)?])))
            .collect::<Option<Vec<_>>>()?;
        let mut powers: Vec<_> = places.into_iter().collect();
        powers.sort_by_key(|(_, place)| *place);
        let powers = powers.into_iter().map(|(power, _)| power).collect();
        let waves = harmonics.iter().map(|(k, _)| waves(*k)).collect();
        Some(Self { powers, frequency, harmonics, waves })
    }

    /// The hbar between -2 and 0 at which the squared residual of the equation is least, with these
    /// values of all other symbols, and omega there; `None` if one is missing or no residual is
    /// finite.
    pub(super) fn least_residual(
        &self,
        force: &CentredForce,
        value_of: impl Fn(Symbol) -> Option<f64>,
    ) -> Option<LeastResidual> {
        const TRIALS: usize = 40;
        let powers = self
            .powers
            .iter()
            .map(|(symbol, exponent)| Some(Scaled::new(value_of(*symbol)?).power(*exponent)));
        let powers: Vec<Scaled> = powers.collect::<Option<_>>()?;
        let frequency = in_hbar(&self.frequency, &powers);
        let omega = |hbar: f64| frequency.iter().rev().fold(0.0, |sum, c| sum * hbar + c);
        // Place and acceleration at the samples, a coefficient for each power of hbar.
        let (mut places, mut accelerations): (Vec<Samples>, Vec<Samples>) = (vec![], vec![]);
        for (harmonic, waves) in self.harmonics.iter().zip(&self.waves) {
            let square = (harmonic.0 * harmonic.0) as f64;
            for (part, wave) in harmonic.1.iter().zip(waves) {
                for (power, coefficient) in in_hbar(part, &powers).into_iter().enumerate() {
                    if places.len() <= power {
                        places.resize(power + 1, [0.0; SAMPLES]);
                        accelerations.resize(power + 1, [0.0; SAMPLES]);
                    }
                    for (j, wave) in wave.iter().enumerate() {
                        places[power][j] += coefficient * wave;
                        accelerations[power][j] -= square * coefficient * wave;
                    }
                }
            }
        }
        let squared_residual = |hbar: f64| {
            let frequency = omega(hbar);
            let value = |series: &[Samples], j: usize| {
                series.iter().rev().fold(0.0, |sum, samples| sum * hbar + samples[j])
            };
            let defect = |j: usize| {
                let distance = value(&places, j) - force.equilibrium();
                frequency * frequency * value(&accelerations, j) + force.value(distance)
            };
            let sum: f64 = (0..SAMPLES).map(|j| defect(j).powi(2)).sum();
            if frequency > 0.0 && sum.is_finite() { sum } else { f64::INFINITY }
        };
        let place = |k: usize| -2.0 * k as f64 / TRIALS as f64;
        let sums: Vec<f64> = (1..=TRIALS).map(|k| squared_residual(place(k))).collect();
        let best = (1..=TRIALS).min_by(|&a, &b| sums[a - 1].total_cmp(&sums[b - 1]))?;
        let (hbar, least) = find_minimum(squared_residual, place(best + 1), place(best - 1));
        least.is_finite().then(|| LeastResidual { hbar, frequency: omega(hbar) })
    }
}

/// The coefficients of the powers of hbar, with these values of the other powers.
fn in_hbar(terms: &[TermInHbar], powers: &[Scaled]) -> Vec<f64> {
    let length = terms.iter().map(|term| term.hbar + 1).max().unwrap_or(0);
    let mut by_power = vec![vec![]; length];
    for term in terms {
        let factors = term.factors.iter();
        by_power[term.hbar]
            .push(factors.fold(term.coefficient, |product, place| product.product(powers[*place])));
    }
    by_power.iter().map(|terms| Scaled::sum(terms)).collect()
}

/// `cos(k theta)` and `sin(k theta)` at the samples.
fn waves(k: usize) -> [Samples; 2] {
    let angle = |j: usize| k as f64 * std::f64::consts::PI * (j as f64 + 0.5) / SAMPLES as f64;
    [std::array::from_fn(|j| angle(j).cos()), std::array::from_fn(|j| angle(j).sin())]
}

//! The motions for all values of a parameter on an interval, enclosed at once about an approximation that
//! changes with the parameter.
//!
//! ```text
//! a = c + h cos(phi),     z(phi) an approximation, z0 its mean, D = max ||z(phi) - z0||
//! Z = Z1 + Z2 R < 1,      Z1 at z0 and Z2 within R of it, for all a:      1 - B F contracts by Z on the ball of radius R about z0
//! s = sum_n ||B F_n||/(1 - Z),      F(z(phi); a) = sum_n F_n cos(n phi),      D + s <= R
//! ```
//!
//! `1 - B F` moves z(phi) by `||B F(z(phi); a)||` at most, and so takes the ball of radius s about z(phi) into
//! itself: for each a there is one motion in it, and no other in the ball of radius R about z0. Z is below one
//! on a wide interval, while s is as small as the approximation is good.
//!
//! In: an approximation, its coefficients Chebyshev's by the parameter. Out: the distance of the motions from
//! it. The cost is that of the theorem, and of the forces over sheets.
//!
//! Source: J. B. van den Berg, J.-P. Lessard: Rigorous numerics in dynamics, Notices of the AMS 62 (2015),
//! 1057-1061, for continuation with a uniform contraction.

use super::super::elementary::Analytic as _;
use super::super::force::along_all;
use super::super::fourier_series::{FourierSeries, WORKING};
use super::super::radii_polynomial::NotProved;
use super::super::sheet::Sheet;
use super::{BoundData, Condition, ConservativeProblem, Theorem};
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::expr::Expr;
use crate::symbol::Symbol;

/// An approximate motion.
#[derive(Clone)]
pub(in super::super) struct ApproximateMotion {
    /// `1/omega^2`.
    pub(in super::super) mu: Ball,
    /// One series for each coordinate.
    pub(in super::super) motions: Vec<FourierSeries>,
}

impl ApproximateMotion {
    /// The distances of `1/omega^2` and of the sum of all coefficients from those of another one.
    pub(in super::super) fn apart(&self, other: &Self) -> [Bound; 2] {
        let series = self.motions.iter().zip(&other.motions);
        let motions = series.map(|(own, other)| own.difference(other).norm()).sum();
        [WORKING.magnitude(&WORKING.difference(&self.mu, &other.mu)), motions]
    }
}

/// A ball that a true motion lies in: `sigma |1/omega^2 - mu|` and the distance of all coefficients together.
pub(in super::super) struct NearMotion {
    pub(in super::super) motion: ApproximateMotion,
    pub(in super::super) distance: Bound,
    pub(in super::super) sigma: Bound,
}

/// An approximate motion for each value of a parameter on an interval.
pub(in super::super) struct ApproximateMotions {
    /// The parameter.
    pub(in super::super) parameter: Sheet,
    /// `1/omega^2`.
    pub(in super::super) mu: Sheet,
    /// One for each coordinate.
    pub(in super::super) motions: Vec<Sheet>,
}

impl ApproximateMotions {
    /// The motion where the series have these coefficients.
    pub(in super::super) fn motion(
        &self,
        coefficients: impl Fn(&Sheet) -> Vec<Ball>,
    ) -> ApproximateMotion {
        let series = |sheet: &Sheet| FourierSeries::exactly(coefficients(sheet), vec![]);
        ApproximateMotion {
            mu: coefficients(&self.mu).first().cloned().unwrap_or_else(Ball::zero),
            motions: self.motions.iter().map(series).collect(),
        }
    }

    /// Whether all harmonics are odd.
    fn is_odd(&self) -> bool {
        let even = |sheet: &Sheet| {
            let mut all = (0..sheet.height()).step_by(2);
            all.all(|k| (0..sheet.width()).all(|n| sheet.coefficient(k, n).is_zero()))
        };
        self.motions.iter().all(even)
    }
}

/// The proof that there is one motion for each value of a parameter on an interval.
pub(in super::super) struct MotionsOnPiece {
    approximate: ApproximateMotions,
    mean: ApproximateMotion,
    sigma: Bound,
    /// The distance of the motions from the approximate ones.
    distance: Bound,
    /// The radius of the ball about the mean that holds one motion at most.
    radius: Bound,
    /// Z.
    contraction: Bound,
}

impl MotionsOnPiece {
    /// The proof for a problem whose motion is the mean of the approximate ones and whose parameter is the whole
    /// interval.
    ///
    /// # Errors
    /// [`NotProved`].
    pub(in super::super) fn new(
        problem: ConservativeProblem,
        approximate: ApproximateMotions,
    ) -> Result<Self, NotProved> {
        /// The part by which the ball is larger than need be: for the motions of pieces beside this one.
        const LARGER: f64 = 65.0 / 64.0;
        const LARGER_AT_LEAST: i32 = -18;
        if problem.odd && !approximate.is_odd() {
            return Err(NotProved::NotOdd);
        }
        let theorem = Theorem::new(problem)?;
        let system = &theorem.system;
        let sigma = system.inverse.sigma;
        let motions: Bound = approximate.motions.iter().map(Sheet::spread).sum();
        let spread = sigma * approximate.mu.spread() + motions;
        let more = sigma.max(Bound::exactly(1.0)) * Bound::power_of_two(LARGER_AT_LEAST);
        let radius = spread * Bound::exactly(LARGER) + more;
        if !system.problem.is_distinct(radius, sigma) {
            return Err(NotProved::TooLarge(radius));
        }
        let [by_mu, by_motion] = system.curvature(&theorem.slopes.expressions, radius)?;
        let contraction = theorem.contraction + by_mu.max(by_motion) * radius;
        let left = contraction.below_complement();
        if left <= 0.0 {
            return Err(NotProved::NoContraction(contraction));
        }
        let defect = defect(system, &approximate)?;
        let distance = defect.over(left);
        if spread + distance > radius {
            return Err(NotProved::TooFar(defect));
        }
        let mean = ApproximateMotion {
            mu: system.problem.mu.clone(),
            motions: system.problem.motions.clone(),
        };
        Ok(Self { approximate, mean, sigma, distance, radius, contraction })
    }

    /// The bound of the contraction, which is below one.
    pub(in super::super) fn contraction(&self) -> f64 {
        self.contraction.value()
    }

    /// The approximate motions.
    pub(in super::super) fn approximate(&self) -> &ApproximateMotions {
        &self.approximate
    }

    /// A bound of the distance of `1/omega^2` from that of the approximate motions.
    pub(in super::super) fn distance_of_mu(&self) -> Bound {
        self.distance.over(self.sigma.value())
    }

    /// A bound of the distances of `1/omega^2` and of the sum of all coefficients together.
    pub(in super::super) fn distance_of_all(&self) -> Bound {
        self.distance_of_mu() + self.distance
    }

    /// The motion at the upper end of the interval.
    pub(in super::super) fn at_end(&self) -> NearMotion {
        let motion = self.approximate.motion(Sheet::at_end);
        NearMotion { motion, distance: self.distance, sigma: self.sigma }
    }

    /// Whether all that may be a motion in another ball is in that of this proof, so that it is the motion
    /// that this proof is about.
    pub(in super::super) fn holds(&self, other: &NearMotion) -> bool {
        // sigma |d mu| + sum |d c| is at most this factor times the same with the other weight.
        let heavier = self.sigma.over(other.sigma.value()).max(Bound::exactly(1.0));
        let [of_mu, of_motions] = self.mean.apart(&other.motion);
        self.sigma * of_mu + of_motions + heavier * other.distance <= self.radius
    }
}

/// A bound of `||B F||` for all approximate motions.
fn defect(system: &BoundData, approximate: &ApproximateMotions) -> Result<Bound, NotProved> {
    let problem = &system.problem;
    let parameter = problem.parameter.iter().map(|(name, _)| (*name, &approximate.parameter));
    let coordinates = problem.coordinates.iter().copied().zip(&approximate.motions);
    let letters: Vec<(Symbol, &Sheet)> = coordinates.chain(parameter).collect();
    let bent = |force: &&Expr| Ok(approximate.mu.product(&along_all(force, &letters)?));
    let bent = problem.forces.iter().map(bent).collect::<Result<Vec<Sheet>, NotProved>>()?;
    let all = || approximate.motions.iter().chain(&bent);
    let height = all().map(Sheet::height).max().unwrap_or(0);
    let width = all().map(Sheet::width).max().unwrap_or(0);
    let (Condition::Start { place: amplitude, .. } | Condition::FirstHarmonic { amplitude, .. }) =
        &problem.condition;
    let part = |n: usize| {
        let series = |sheet: &Sheet| {
            let cosines = (0..sheet.height()).map(|k| sheet.coefficient(k, n));
            FourierSeries::exactly(cosines.collect(), vec![])
        };
        let motions: Vec<FourierSeries> = approximate.motions.iter().map(series).collect();
        let along = problem.condition_along(&motions);
        let start = if n == 0 { WORKING.difference(&along, amplitude) } else { along };
        system.norm(&system.image(start, height, |wave| {
            let (i, k) = (wave.coordinate, wave.harmonic);
            let inertia = WORKING.scaled(&motions[i].cosine(k), -i64::from(wave.squared()));
            WORKING.sum(&inertia, &bent[i].coefficient(k, n))
        }))
    };
    let tails: Bound = bent.iter().map(|sheet| sheet.tail).sum();
    let seen: Bound = (0..width).map(part).sum();
    Ok(seen + system.size * tails)
}

//! The motions for all complex values of a parameter on a disc, and those at single values, enclosed by
//! the proof for the disc.
//!
//! ```text
//! ||B F(z0; a)|| <= ||B F(z0; c)|| + rho ||B F_a(z0; c)|| + (rho^2/2) sup ||B F_aa(z0; a)|| = Y0     |a - c| <= rho
//! Z = Z1 + Z2 r < 1,  Z1 and Z2 for all a of the disc:     1 - B F contracts by Z on the ball of radius r about z0
//! ||z(a) - z|| <= ||B F(z; a)||/(1 - Z)                    for any z of that ball
//! ```
//!
//! All norms hold for complex numbers too, so that z(a) is the fixed point of a map that contracts alike for all
//! a and is analytic in a: the motion is an analytic function on the disc. For a real a it is real, since
//! its conjugate is one too and there is only one in the ball.
//!
//! In: an approximate motion in the middle of the disc, and the radius. Out: the proof, and from the defect
//! of any other approximation alone the distance of the true motion from it.
//!
//! Source: J. B. van den Berg, J.-P. Lessard: Rigorous numerics in dynamics, Notices of the AMS 62 (2015),
//! 1057-1061, for continuation with a uniform contraction. The cost is that of the theorem.

use super::super::fourier_series::{FourierSeries, WORKING};
use super::super::radii_polynomial::{NotProved, Proof, radius};
use super::{BoundData, ConservativeProblem, Theorem};
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::expr::{Expr, ExprError};

/// An approximate motion.
#[derive(Clone)]
pub(in super::super) struct ApproximateMotion {
    /// `1/omega^2`.
    pub(in super::super) mu: Ball,
    /// One series for each coordinate.
    pub(in super::super) motions: Vec<FourierSeries>,
}

/// The distance of the true motion from an approximate one.
pub(in super::super) struct NearMotion {
    /// A bound of it for `1/omega^2`.
    pub(in super::super) of_mu: Bound,
    /// A bound of it in the norm of the proof that found it.
    distance: Bound,
    /// The weight of mu in that norm.
    sigma: Bound,
}

/// The proof that there is one motion for each value of a parameter on a disc.
pub(in super::super) struct MotionsOnDisc<'a> {
    /// The equations with the parameter in the middle.
    centre: ConservativeProblem<'a>,
    proof: Proof,
    sigma: Bound,
}

impl NearMotion {
    /// A bound of the distance of `1/omega^2` and of the sum of those of the coefficients together.
    pub(in super::super) fn of_all(&self) -> Bound {
        self.of_mu + self.distance
    }
}

impl<'a> MotionsOnDisc<'a> {
    /// The proof for all values within `rho` of that of the parameter in a problem.
    ///
    /// # Errors
    /// [`NotProved`].
    pub(in super::super) fn new(
        problem: ConservativeProblem<'a>,
        rho: Bound,
    ) -> Result<Self, NotProved> {
        let own = BoundData::new(problem.clone())?;
        let mut on_disc = problem.clone();
        if let Some((_, value)) = &mut on_disc.parameter {
            value.radius += rho;
        }
        let by_parameter = |force: &Expr| match &problem.parameter {
            Some((name, _)) => force.differentiate(*name),
            None => Ok(Expr::zero()),
        };
        let slopes: Vec<Expr> = problem
            .forces
            .iter()
            .map(|force| by_parameter(force))
            .collect::<Result<_, ExprError>>()?;
        let mu = WORKING.magnitude(&problem.mu);
        let mut bend = Bound::ZERO;
        for slope in &slopes {
            bend += on_disc.values_along(&by_parameter(slope)?, &problem.motions)?.norm();
        }
        let along = |slope: &Expr| problem.values_along(slope, &problem.motions);
        let slopes = slopes.iter().map(along).collect::<Result<Vec<FourierSeries>, _>>()?;
        let tails: Bound = slopes.iter().map(|slope| slope.tail).sum();
        let turned = own.image(Ball::zero(), BoundData::longest(&slopes), |wave| {
            WORKING.product(&problem.mu, &slopes[wave.coordinate].cosine(wave.harmonic))
        });
        let slope = own.norm(&turned) + own.size * mu * tails;
        let defect = own.defect() + rho * slope + rho * rho * own.size * mu * bend / 2;
        let theorem = Theorem::new(on_disc)?;
        let curvature = |within| {
            let [by_mu, by_motion] =
                theorem.system.curvature(&theorem.slopes.expressions, within)?;
            Ok(by_mu.max(by_motion))
        };
        let sigma = own.inverse.sigma;
        let distinct = |radius: Bound| problem.is_distinct(radius, sigma);
        let proof = radius(defect, theorem.contraction, curvature, distinct)?;
        Ok(Self { centre: problem, proof, sigma })
    }

    /// A bound of `|mu - mu_0|` on the disc, `mu_0` that of the approximate motion.
    pub(in super::super) fn spread_of_mu(&self) -> Bound {
        self.proof.radius.over(self.sigma.value())
    }

    /// `2 Y0 Z2/(1 - Z1)^2`, which is below one where there is a proof.
    pub(in super::super) fn room(&self) -> f64 {
        let left = self.proof.contraction.below_complement();
        2.0 * (self.proof.defect * self.proof.curvature).value() / (left * left)
    }

    /// The distance of the true motion for some values of the parameter on the disc from an approximate one;
    /// `None` where this one is not in the ball.
    ///
    /// # Errors
    /// A force without a value.
    pub(in super::super) fn near(
        &self,
        parameter: &Ball,
        motion: &ApproximateMotion,
    ) -> Result<Option<NearMotion>, NotProved> {
        if self.distance(motion, self.sigma) > self.proof.radius {
            return Ok(None);
        }
        let mut problem = self.centre.clone();
        if let Some((_, value)) = &mut problem.parameter {
            *value = parameter.clone();
        }
        (problem.mu, problem.motions) = (motion.mu.clone(), motion.motions.clone());
        let defect = BoundData::new(problem)?.defect();
        let Proof { radius, contraction, curvature, .. } = self.proof;
        let distance = defect.over((contraction + curvature * radius).below_complement());
        let of_mu = distance.over(self.sigma.value());
        Ok(Some(NearMotion { of_mu, distance, sigma: self.sigma }))
    }

    /// Whether the motion that another proof found near an approximate one is in this ball, so that it is
    /// the motion that this proof is about.
    pub(in super::super) fn holds(&self, motion: &ApproximateMotion, found: &NearMotion) -> bool {
        // sigma |d mu| + sum |d c| is at most this factor times the same with the other weight.
        let heavier = self.sigma.over(found.sigma.value()).max(Bound::exactly(1.0));
        self.distance(motion, self.sigma) + heavier * found.distance <= self.proof.radius
    }

    /// The distance of an approximate motion from that in the middle.
    fn distance(&self, motion: &ApproximateMotion, sigma: Bound) -> Bound {
        let series = self.centre.motions.iter().zip(&motion.motions);
        let apart: Bound = series.map(|(own, other)| own.difference(other).norm()).sum();
        sigma * WORKING.magnitude(&WORKING.difference(&self.centre.mu, &motion.mu)) + apart
    }
}

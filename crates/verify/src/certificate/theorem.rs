//! The theorem: whether there is exactly one motion near an approximate one, and how near.
//!
//! For `x'' + f(x) = 0`, `x(0) = A`, `x'(0) = 0`, and `x(t) = X(omega t)`,
//! `X(theta) = sum c_k cos(k theta)`, `mu = 1/omega^2`:
//!
//! ```text
//! F_eta = sum_k c_k - A,      F_k = -k^2 c_k + mu [f(c)]_k                    the equation in harmonics, k <= N and beyond
//! Y0 >= ||B F(mu, c)||,       Z1 >= ||1 - B DF(mu, c)||,      Z2 >= Lipschitz constant of B DF on the ball of radius R
//! D = (1 - Z1)^2 - 2 Y0 Z2,   r = 2 Y0/((1 - Z1) + sqrt(D))                   norm: sigma |mu| + sum_k |c_k|
//! ```
//!
//! If `Z1 < 1`, `D > 0`, `r <= R`, `Z1 + Z2 r < 1`, `r/sigma < mu` and `r < |c_1|`, the map `1 - B
//! F` takes the ball of radius r about the approximation into itself and contracts there: it holds
//! exactly one solution, whose smallest period is `2 pi sqrt(mu)`. The approximate inverse B is a
//! matrix on `mu` and the harmonics up to N, and `-1/k^2` beyond, where the sum of the corrections
//! enters the condition at `t = 0`. No input is trusted: any numbers may be claimed, and every
//! inequality is checked in balls.
//!
//! Source: S. Day, J.-P. Lessard, K. Mischaikow: Validated continuation for equilibria of PDEs,
//! SIAM Journal on Numerical Analysis 45 (2007), 1398-1424; J. B. van den Berg, J.-P. Lessard:
//! Rigorous numerics in dynamics, Notices of the AMS 62 (2015), 1057-1061. The cost is that of N^3
//! products of short integers.

use super::approximate_inverse::{Inverse, SHORT};
use super::force::along;
use super::fourier_series::{FourierSeries, WORKING};
use super::radii_polynomial::{Correction, NotProved, Proof, radius};
use super::{Certificate, HIGHEST_HARMONIC, coordinate};
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::expr::Expr;

/// Columns beyond which those of all further harmonics are bounded together.
const MOST_COLUMNS: usize = 20 * HIGHEST_HARMONIC;

/// Checks a certificate. The numbers in it may be anything.
///
/// # Errors
/// [`NotProved`].
pub(super) fn prove(certificate: &Certificate) -> Result<Proof, NotProved> {
    Theorem::new(certificate)?.proof(Bound::ZERO)
}

/// The motions of all starts near that of a certificate.
pub(super) struct Neighbours {
    /// `1/omega^2` of every one of them.
    pub(super) mu: Ball,
    /// `1/omega^2` of the start of the certificate itself.
    pub(super) mu_in_middle: Ball,
    /// The derivative of `1/omega^2` by the start, at every one of them.
    pub(super) slope: Ball,
}

/// Checks a certificate for every start that is within `spread` of its own: each has one motion
/// within the radius. The equations differ in the condition at `t = 0` alone, by no more than that.
/// With u the unknowns of a motion, `DF(u) u' = e_eta` for the derivative u' by the start, and for
/// any v
///
/// ```text
/// ||u' - v|| <= (||B (e_eta - DF(ubar) v)|| + Z2 r ||v||)/(1 - Z1 - Z2 r)
/// ```
///
/// # Errors
/// [`NotProved`].
pub(super) fn prove_around(
    certificate: &Certificate,
    spread: Bound,
) -> Result<Neighbours, NotProved> {
    let theorem = Theorem::new(certificate)?;
    let [of_middle, of_all] = [theorem.proof(Bound::ZERO)?, theorem.proof(spread)?];
    let sigma = theorem.system.inverse.sigma.value();
    let widened =
        |ball: &Ball, by: Bound| Ball { middle: ball.middle.clone(), radius: ball.radius + by };
    let (direction, left) = theorem.system.slope_by_start(&theorem.slope);
    let turned = of_all.curvature * of_all.radius;
    let contracts = (of_all.contraction + turned).below_complement();
    let size = Bound::power_of_two(certificate.sigma) * WORKING.magnitude(&direction.mu)
        + direction.harmonics.norm();
    let apart = (left + turned * size).over(contracts);
    let around = |proof: &Proof| widened(&theorem.system.mu, proof.radius.over(sigma));
    Ok(Neighbours {
        mu: around(&of_all),
        mu_in_middle: around(&of_middle),
        slope: widened(&direction.mu, apart.over(sigma)),
    })
}

/// A direction of `mu` and the harmonics.
struct Direction {
    mu: Ball,
    harmonics: FourierSeries,
}

impl Direction {
    /// Adds the middles of a correction.
    fn add(&mut self, correction: &Correction<usize>, block: &[usize]) {
        let added = |to: &Ball, ball: &Ball| Ball {
            middle: &to.middle + &ball.middle,
            radius: Bound::ZERO,
        };
        self.mu = added(&self.mu, &correction.block[0]);
        let cosines = &mut self.harmonics.cosines;
        let in_block = block.iter().zip(&correction.block[1..]);
        for (&k, ball) in in_block.chain(correction.beyond.iter().map(|(k, ball)| (k, ball))) {
            cosines.resize(cosines.len().max(k + 1), Ball::zero());
            cosines[k] = added(&cosines[k], ball);
        }
    }
}

/// The bounds of a certificate from which its proofs follow.
struct Theorem<'a> {
    system: BoundData<'a>,
    /// f' and f''.
    derivatives: [Expr; 2],
    slope: Slope,
    defect: Bound,
    contraction: Bound,
}

impl<'a> Theorem<'a> {
    fn new(certificate: &'a Certificate) -> Result<Self, NotProved> {
        if certificate.odd && !certificate.is_odd()? {
            return Err(NotProved::NotOdd);
        }
        let system = BoundData::new(certificate)?;
        let first = certificate.force.differentiate(coordinate())?;
        let second = first.differentiate(coordinate())?;
        let slope = Slope::new(along(&first, &system.motion)?);
        Ok(Self {
            defect: system.defect(),
            contraction: system.contraction(&slope)?,
            derivatives: [first, second],
            slope,
            system,
        })
    }

    /// The proof for every start within `spread`.
    fn proof(&self, spread: Bound) -> Result<Proof, NotProved> {
        let certificate = self.system.certificate;
        let defect = self.defect + spread * self.system.start;
        let curvature = |within| self.system.curvature(self.derivatives.each_ref(), within);
        let distinct = |radius: Bound| {
            radius.over(self.system.inverse.sigma.value()).value() < certificate.size_of_mu()
                && radius.value() < certificate.size_of_first_harmonic()
        };
        radius(defect, self.contraction, curvature, distinct)
    }
}

/// The Newton correction: subtracted from `mu` and the harmonics of a certificate, it brings them
/// nearer to the solution. It proves nothing.
///
/// # Errors
/// As [`prove`].
pub(super) fn correction(certificate: &Certificate) -> Result<Correction<usize>, NotProved> {
    Ok(BoundData::new(certificate)?.correction())
}

/// `f'(c)`, by which the derivative multiplies.
struct Slope {
    series: FourierSeries,
    /// Its coefficients by harmonic as those of exponentials, `s_0 = g_0`, `s_m = g_m/2`.
    halves: Vec<Ball>,
}

impl Slope {
    fn new(series: FourierSeries) -> Self {
        let halved = |(k, ball): (usize, &Ball)| {
            if k == 0 { ball.clone() } else { WORKING.divided(ball, 2) }
        };
        Self { halves: series.cosines.iter().enumerate().map(halved).collect(), series }
    }

    /// `M_kj`: the coefficient of `cos k theta` in `f'(c) cos j theta`.
    fn coefficient(&self, k: usize, j: usize) -> Ball {
        let half = |m: usize| self.halves.get(m).cloned().unwrap_or_else(Ball::zero);
        match (k, j) {
            (_, 0) => self.series.cosine(k),
            (0, _) => half(j),
            _ => WORKING.sum(&half(k.abs_diff(j)), &half(k + j)),
        }
    }
}

/// The quantities from which the bounds Y0, Z1 and Z2 are computed.
struct BoundData<'a> {
    certificate: &'a Certificate,
    inverse: Inverse,
    motion: FourierSeries,
    mu: Ball,
    /// `f(c)`.
    force: FourierSeries,
    /// The harmonics of the block.
    block: Vec<usize>,
    /// The norm of the column of the condition at `t = 0`.
    start: Bound,
    /// The norm of the inverse on the equations of the harmonics.
    size: Bound,
}

impl<'a> BoundData<'a> {
    fn new(certificate: &'a Certificate) -> Result<Self, NotProved> {
        let motion = certificate.motion();
        let force = along(&certificate.force, &motion)?;
        let inverse = Inverse::from_entries(
            &certificate.inverse,
            certificate.inverse_bits,
            certificate.sigma,
        );
        let block = certificate.block();
        let start = inverse.norm_of_column(0);
        let columns = (1..=block.len()).map(|column| inverse.norm_of_column(column));
        let next = certificate.highest + certificate.step();
        let beyond = (Bound::exactly(1.0) + start).over((next * next) as f64);
        let size = columns.fold(beyond, Bound::max);
        Ok(Self {
            certificate,
            inverse,
            mu: certificate.mu_ball(),
            motion,
            force,
            block,
            start,
            size,
        })
    }

    /// The harmonics from one up to another, of those that the motion may have.
    fn harmonics(&self, from: usize, to: usize) -> impl Iterator<Item = usize> + use<> {
        let (step, first) = (self.certificate.step(), self.certificate.first());
        let from = match from % step == first % step {
            true => from,
            false => from + 1,
        };
        (from..=to).step_by(step)
    }

    /// The harmonics beyond the block, up to this one.
    fn beyond(&self, to: usize) -> impl Iterator<Item = usize> + use<> {
        self.harmonics(self.certificate.highest + 1, to)
    }

    fn square(k: usize) -> u32 {
        u32::try_from(k * k).unwrap_or(u32::MAX)
    }

    /// `mu f_k`.
    fn accelerated(&self, k: usize) -> Ball {
        WORKING.product(&self.mu, &self.force.cosine(k))
    }

    /// `B F`: the correction of `mu` and of every harmonic, the amount by which the approximation
    /// is off.
    fn correction(&self) -> Correction<usize> {
        let last = self.motion.cosines.len().max(self.force.cosines.len());
        let sum = self.motion.at_zero();
        let start = WORKING.difference(&sum, &WORKING.fraction(&self.certificate.start));
        self.image(start, last, |k| {
            let inertia = WORKING.scaled(&self.motion.cosine(k), -i64::from(Self::square(k)));
            WORKING.sum(&inertia, &self.accelerated(k))
        })
    }

    /// B applied to the residuals: of the condition at the start, and of the equations of the
    /// harmonics up to a given one.
    fn image(
        &self,
        mut start: Ball,
        last: usize,
        equation: impl Fn(usize) -> Ball,
    ) -> Correction<usize> {
        let mut beyond = vec![];
        for k in self.beyond(last) {
            let y = WORKING.scaled(&WORKING.divided(&equation(k), Self::square(k)), -1);
            start = WORKING.difference(&start, &y);
            beyond.push((k, y));
        }
        let mut vector = vec![start];
        vector.extend(self.block.iter().map(|&k| equation(k)));
        Correction { block: self.inverse.image(&vector, WORKING), beyond }
    }

    /// The norm of `mu` and harmonics.
    fn norm(&self, vector: &Correction<usize>) -> Bound {
        let beyond: Bound = vector.beyond.iter().map(|(_, y)| WORKING.magnitude(y)).sum();
        self.inverse.norm(&vector.block, WORKING) + beyond
    }

    /// Approximates the derivative of `mu` and the harmonics by the start by some v, and bounds
    /// `||B (e_eta - DF v)||`.
    fn slope_by_start(&self, slope: &Slope) -> (Direction, Bound) {
        /// Steps of Newton's iteration, each of which gains the digits of Z1.
        const STEPS: usize = 6;
        let one = WORKING.integer(1);
        let mut direction =
            Direction { mu: Ball::zero(), harmonics: FourierSeries::exactly(vec![], vec![]) };
        let mut step = 0;
        loop {
            let waves = &direction.harmonics;
            let bent = slope.series.product(waves);
            let last = self.force.cosines.len().max(bent.cosines.len()).max(waves.cosines.len());
            let left = self.image(WORKING.difference(&one, &waves.at_zero()), last, |k| {
                let inertia = WORKING.scaled(&waves.cosine(k), i64::from(Self::square(k)));
                let moved = WORKING.sum(
                    &WORKING.product(&direction.mu, &self.force.cosine(k)),
                    &WORKING.product(&self.mu, &bent.cosine(k)),
                );
                WORKING.difference(&inertia, &moved)
            });
            if step == STEPS {
                let unseen = WORKING.magnitude(&direction.mu) * self.force.tail
                    + WORKING.magnitude(&self.mu) * bent.tail;
                let left = self.norm(&left) + self.size * unseen;
                return (direction, left);
            }
            direction.add(&left, &self.block);
            step += 1;
        }
    }

    /// Y0.
    fn defect(&self) -> Bound {
        let unseen = self.size * WORKING.magnitude(&self.mu) * self.force.tail;
        self.norm(&self.correction()) + unseen
    }

    /// Z1.
    fn contraction(&self, slope: &Slope) -> Result<Bound, NotProved> {
        let mu = WORKING.magnitude(&self.mu);
        let last = slope.series.cosines.len();
        let highest = self.certificate.highest;
        let mut largest = self.column_of_mu();
        for (index, &j) in self.block.iter().enumerate() {
            largest = largest.max(self.column(slope, j, Some(index + 1)));
        }
        // Columns with entries in the block, where the coefficients of f' couple them to it, then
        // beyond.
        for j in self.beyond(highest + last) {
            largest = largest.max(self.column(slope, j, None));
        }
        let all = mu * (Bound::exactly(1.0) + self.start) * slope.series.finite_norm();
        let mut upto = highest + last;
        let rest = loop {
            let far = (upto + 1 - last) as f64;
            let rest = all.over(far * far);
            if rest < Bound::exactly(0.2) || rest < largest {
                break rest;
            }
            if upto > MOST_COLUMNS {
                return Err(NotProved::NoContraction(rest));
            }
            upto += self.certificate.step();
        };
        for j in self.harmonics(highest + last + 1, upto) {
            largest = largest.max(self.column(slope, j, None));
        }
        Ok(largest.max(rest) + self.size * mu * slope.series.tail)
    }

    /// The column of `mu`.
    fn column_of_mu(&self) -> Bound {
        let short = |ball: &Ball| SHORT.converted(ball, WORKING);
        let (mut start, mut tail) = (Ball::zero(), Bound::ZERO);
        for k in self.beyond(self.force.cosines.len()) {
            let part = WORKING.divided(&self.force.cosine(k), Self::square(k));
            start = WORKING.sum(&start, &part);
            tail += WORKING.magnitude(&part);
        }
        let mut vector = vec![short(&start)];
        vector.extend(self.block.iter().map(|&k| short(&self.force.cosine(k))));
        let block = self.inverse.distance_from_unit(&vector, Some(0));
        (block + tail + self.size * self.force.tail).over(self.inverse.sigma.value())
    }

    /// The column of a harmonic, in the block at this place or beyond it.
    fn column(&self, slope: &Slope, j: usize, place: Option<usize>) -> Bound {
        let last = slope.series.cosines.len();
        let part = |k: usize| WORKING.product(&self.mu, &slope.coefficient(k, j));
        let (mut start, mut tail) = (Ball::zero(), Bound::ZERO);
        let from = (self.certificate.highest + 1).max((j + 1).saturating_sub(last));
        for k in self.harmonics(from, j + last) {
            let image = WORKING.divided(&part(k), Self::square(k));
            start = WORKING.sum(&start, &image);
            tail += WORKING.magnitude(&image);
        }
        // Far beyond the block, f' does not couple a harmonic to it; only the condition at t = 0
        // does.
        if j > self.certificate.highest + last {
            return tail + self.start * WORKING.magnitude(&start);
        }
        if place.is_some() {
            start = WORKING.sum(&start, &WORKING.integer(1));
        }
        let mut vector = vec![SHORT.converted(&start, WORKING)];
        vector.extend(self.block.iter().map(|&k| {
            let mut entry = part(k);
            if k == j {
                entry = WORKING.difference(&entry, &WORKING.integer(i64::from(Self::square(k))));
            }
            SHORT.converted(&entry, WORKING)
        }));
        self.inverse.distance_from_unit(&vector, place) + tail
    }

    /// Z2 on the ball of this radius.
    fn curvature(&self, derivatives: [&Expr; 2], radius: Bound) -> Result<Bound, NotProved> {
        let ball = self.motion.clone().widened(radius);
        let norm = |force: &Expr| along(force, &ball).map(|series| series.norm());
        let [first, second] = derivatives;
        let sigma = self.inverse.sigma.value();
        let mu = WORKING.magnitude(&self.mu) + radius.over(sigma);
        Ok(self.size * norm(first)?.over(sigma).max(mu * norm(second)?))
    }
}

//! The theorem: whether there is exactly one motion near an approximate one, and how near.
//!
//! For `x'' + f(x) = 0`, `x(0) = A`, `x'(0) = 0`, and `x(t) = X(omega t)`, `X(theta) = sum c_k cos(k theta)`, `mu = 1/omega^2`:
//!
//! ```text
//! F_eta = sum_k c_k - A,      F_k = -k^2 c_k + mu [f(c)]_k                    the equation in harmonics, k <= N and beyond
//! Y0 >= ||B F(mu, c)||,       Z1 >= ||1 - B DF(mu, c)||,      Z2 >= Lipschitz constant of B DF on the ball of radius R
//! D = (1 - Z1)^2 - 2 Y0 Z2,   r = 2 Y0/((1 - Z1) + sqrt(D))                   norm: sigma |mu| + sum_k |c_k|
//! ```
//!
//! If `Z1 < 1`, `D > 0`, `r <= R`, `Z1 + Z2 r < 1`, `r/sigma < mu` and `r < |c_1|`, the map `1 - B F` takes the ball of radius r about
//! the approximation into itself and contracts there: it holds exactly one solution, whose smallest period is `2 pi sqrt(mu)`. The
//! approximate inverse B is a matrix on `mu` and the harmonics up to N, and `-1/k^2` beyond, whose sum the condition at `t = 0`
//! feels. Nothing that is read here is trusted: any numbers may be claimed, and every inequality is checked in balls.
//!
//! Source: S. Day, J.-P. Lessard, K. Mischaikow: Validated continuation for equilibria of PDEs, SIAM Journal on Numerical Analysis
//! 45 (2007), 1398-1424; J. B. van den Berg, J.-P. Lessard: Rigorous numerics in dynamics, Notices of the AMS 62 (2015),
//! 1057-1061. The cost is that of N^3 products of short integers.

use super::approximate_inverse::{Inverse, SHORT, image};
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
    prove_around(certificate, Bound::ZERO)
}

/// The same for every start that is within `spread` of that of the certificate: each has one motion within the radius. The equations
/// differ in the condition at `t = 0` alone, by no more than that.
///
/// # Errors
/// [`NotProved`].
pub(super) fn prove_around(certificate: &Certificate, spread: Bound) -> Result<Proof, NotProved> {
    if certificate.odd && !certificate.is_odd()? {
        return Err(NotProved::NotOdd);
    }
    let system = System::of(certificate)?;
    let first = certificate.force.differentiate(coordinate())?;
    let second = first.differentiate(coordinate())?;
    let defect = system.defect() + spread * system.start;
    let contraction = system.contraction(&Slope::of(along(&first, &system.motion)?))?;
    let curvature = |within| system.curvature([&first, &second], within);
    let distinct = |radius: Bound| {
        radius.over(system.inverse.sigma.value()).value() < certificate.size_of_mu()
            && radius.value() < certificate.size_of_first_harmonic()
    };
    radius(defect, contraction, curvature, distinct)
}

/// What is to be subtracted from `mu` and the harmonics of a certificate, so that it is nearer to the solution; nothing is proved
/// of it.
///
/// # Errors
/// As [`prove`].
pub(super) fn correction(certificate: &Certificate) -> Result<Correction<usize>, NotProved> {
    Ok(System::of(certificate)?.correction())
}

/// `f'(c)`, by which the derivative multiplies.
struct Slope {
    series: FourierSeries,
    /// Its coefficients by harmonic as those of exponentials, `s_0 = g_0`, `s_m = g_m/2`.
    halves: Vec<Ball>,
}

impl Slope {
    fn of(series: FourierSeries) -> Self {
        let halved = |(k, ball): (usize, &Ball)| if k == 0 { ball.clone() } else { WORKING.divided(ball, 2) };
        Self {
            halves: series.cosines.iter().enumerate().map(halved).collect(),
            series,
        }
    }

    /// `M_kj`: the coefficient of `cos k theta` in `f'(c) cos j theta`.
    fn at(&self, k: usize, j: usize) -> Ball {
        let half = |m: usize| self.halves.get(m).cloned().unwrap_or_else(Ball::zero);
        match (k, j) {
            (_, 0) => self.series.cosine(k),
            (0, _) => half(j),
            _ => WORKING.sum(&half(k.abs_diff(j)), &half(k + j)),
        }
    }
}

/// What the bounds are made of.
struct System<'a> {
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

impl<'a> System<'a> {
    fn of(certificate: &'a Certificate) -> Result<Self, NotProved> {
        let motion = certificate.motion();
        let force = along(&certificate.force, &motion)?;
        let inverse = Inverse::of(&certificate.inverse, certificate.inverse_bits, certificate.sigma);
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

    /// Those beyond the block, up to one.
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

    /// `B F`: the correction of `mu` and of every harmonic, by which the approximation is the further off.
    fn correction(&self) -> Correction<usize> {
        let last = self.motion.cosines.len().max(self.force.cosines.len());
        let zero = Ball::zero();
        let mut start = self.motion.cosines.iter().fold(zero, |sum, c| WORKING.sum(&sum, c));
        start = WORKING.difference(&start, &WORKING.fraction(&self.certificate.start));
        let mut beyond = vec![];
        for k in self.beyond(last) {
            let image = WORKING.divided(&self.accelerated(k), Self::square(k));
            let y = WORKING.difference(&self.motion.cosine(k), &image);
            start = WORKING.difference(&start, &y);
            beyond.push((k, y));
        }
        let mut vector = vec![start];
        vector.extend(self.block.iter().map(|&k| {
            let inertia = WORKING.scaled(&self.motion.cosine(k), -i64::from(Self::square(k)));
            WORKING.sum(&inertia, &self.accelerated(k))
        }));
        Correction {
            block: image(&self.inverse.entries, &vector, WORKING),
            beyond,
        }
    }

    /// Y0.
    fn defect(&self) -> Bound {
        let correction = self.correction();
        let beyond: Bound = correction.beyond.iter().map(|(_, y)| WORKING.magnitude(y)).sum();
        let unseen = self.size * WORKING.magnitude(&self.mu) * self.force.tail;
        self.inverse.norm(&correction.block, WORKING) + beyond + unseen
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
        // Where the coefficients of f' reach into the block, and beyond.
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
        let part = |k: usize| WORKING.product(&self.mu, &slope.at(k, j));
        let (mut start, mut tail) = (Ball::zero(), Bound::ZERO);
        let from = (self.certificate.highest + 1).max((j + 1).saturating_sub(last));
        for k in self.harmonics(from, j + last) {
            let image = WORKING.divided(&part(k), Self::square(k));
            start = WORKING.sum(&start, &image);
            tail += WORKING.magnitude(&image);
        }
        // Far beyond, nothing of f' reaches the block: the condition at t = 0 alone does.
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

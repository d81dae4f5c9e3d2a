//! The theorem for equations with damping: whether there is exactly one periodic motion near an
//! approximate one, and how near.
//!
//! For `x'' + g(x) x' + h(x) = 0` of one coordinate or several, and `x(t) = X(omega t)`,
//! `X(theta) = sum_k (a_k cos(k theta) + b_k sin(k theta))`, `p = 1/omega`:
//!
//! ```text
//! F = X'' + p g(X) X' + p^2 h(X),    F_k = -k^2 X_k + p [phi(X)']_k + p^2 [h(X)]_k,   phi' = g      one for each cosine and sine
//! b_1 = 0                            the phase, of one coordinate: p takes the place of b_1 among the unknowns
//! norm: sigma |p| + sum_k (|a_k| + |b_k|)
//! ```
//!
//! Of several coordinates x, h and phi are vectors, `g_ij = dphi_i/dx_j` is a matrix, sums are over
//! all coordinates, and where a norm or a truncated part of a derivative of g or h occurs below it is
//! the largest sum over the equations i of one derivative: `max_j sum_i ||g_ij||`,
//! `max_jl sum_i ||d^2 h_i/dx_j dx_l||`. A matrix g of which this is not true, `dg_ij/dx_l` other than
//! `dg_il/dx_j`, is none of this theorem: [`DampedProblem::has_potential_damping`].
//!
//! The approximate inverse B is a matrix on the harmonics up to N, and `-1/k^2` beyond. With `alpha
//! = ||B||`, and `beta` the norm of B times a derivative by theta, both on the space of the
//! equations,
//!
//! ```text
//! alpha = max(max_(k <= N) ||B e_k||, 1/(N+1)^2)         beta = max(max_(k <= N) k ||B e_k||, 1/(N+1))
//! Y0 = ||B_N F_N|| + sum_(k > N) |F_k|/k^2 + alpha (p eps_D + p^2 eps_h)
//! Z1 = beta p eps_g + alpha p^2 eps_h' + max of
//!   column of p         (||B_N (D + 2 p h)_N - e_p|| + sum_(k > N) |(D + 2 p h)_k|/k^2 + alpha (eps_D + 2 p eps_h))/sigma
//!   column e of j <= N  ||B_N DF_N e - e|| + sum_(k > N) |DF_k e|/k^2,    DF e = e'' + p (g e)' + p^2 h' e
//!   N < j <= N + W      ||B_N DF_N e|| + sum_(k > N) |p (g e)'_k + p^2 (h' e)_k|/k^2
//!   N + W < j <= J      the sum alone
//!   j > J               p ||g||/(J + 1 - W) + p^2 ||h'||/(J + 1 - W)^2
//! Z2 = max(2 alpha ||h||/sigma^2, (beta ||g|| + 2 P alpha ||h'||)/sigma, beta P ||g'|| + alpha P^2 ||h''||),   P = p + R/sigma
//! ```
//!
//! where `D = g(X) X'`, eps is the norm of the truncated part of a series, W is the last harmonic
//! of g(X) and h'(X), and the norms of Z2 are over the ball of radius R. Z2 bounds the second
//! derivative of F at u = (q, v) and u' = (q', v'), `q (g v')' + q' (g v)' + 2 q q' h + 2 p h' (q
//! v' + q' v) + p (g' v v')' + p^2 h'' v v'`, term by term.
//!
//! If `Z1 < 1`, `D > 0`, `r <= R`, `Z1 + Z2 r < 1` (`radii_polynomial.rs`), `r/sigma < p` and
//! `r < a_1` of that coordinate, there is exactly one zero of F in the ball of radius r: B is onto, hence its matrix
//! is invertible, hence it is injective. `k X_k` is summable, for `phi(X)` is, and so is `k^2 X_k`:
//! `X(t/p)` is a motion, at rest or of a part of the period only if a_1 were zero. DF is injective
//! there. Were the second of Floquet's multipliers one too, a periodic solution of the variational
//! equation, or one that grows like `t x'(t)`, would be in its kernel, with some of X' added where
//! it has a sine of the first harmonic (X' has, for a_1 is not zero): so the motion is a limit
//! cycle, and it attracts where `-[g(X)]_0`, by Liouville's formula its characteristic exponent, is
//! negative.
//!
//! If the motion is sought among those of odd harmonics, the statement is about these alone: there
//! is exactly one zero of odd harmonics in the ball, and one with even harmonics may be as near. A
//! limit cycle is isolated all the same: half a period and a turn of x are a map whose second
//! multiplier is positive, and the root of that of the period; were that one, so were this, and the
//! solution above would have odd harmonics. Of several coordinates there are other multipliers,
//! roots of one among them perhaps: there the statement is that no other motion of odd harmonics,
//! or of all where it is proved of all, has nearly this period and is near.
//!
//! Of a driven equation, `x'' + g(x) x' + h(x, cos(Omega t), sin(Omega t)) = 0`, p is known, a
//! whole number n of periods of the drive to a turn of theta: `p = n/Omega`. Then p is not an
//! unknown, b_1 is one, and all terms that belong to p above are left out: its column, the first
//! two terms of Z2, and `R/sigma` in P. h along X contains the drive as `cos(n theta)` and `sin(n
//! theta)`; h' is its derivative by x. The zero in the ball is a motion that repeats itself after n
//! periods of the drive; its smallest period may be shorter. Its stability is another theorem
//! (`stability.rs`).
//!
//! Source: A. Hungria, J.-P. Lessard, J. D. Mireles James: Rigorous numerics for analytic solutions
//! of differential equations: the radii polynomial approach, Mathematics of Computation 85 (2016),
//! 1427-1459; J. B. van den Berg, J.-P. Lessard: Rigorous numerics in dynamics, Notices of the AMS
//! 62 (2015), 1057-1061. The cost is that of `N^2 (N + W)` products of short integers.

use super::super::HIGHEST_HARMONIC;
use super::super::approximate_inverse::{Inverse, SHORT};
use super::super::force::NoValue;
use super::super::fourier_series::{BasisFunction, FourierSeries, WORKING};
use super::super::radii_polynomial::{Correction, NotProved, Proof, radius};
use super::problem::{
    CoordinateWave, DampedProblem, ROUGH, SeriesMatrix, image_of, largest_column,
};
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::expr::{Expr, ExprError};

/// Columns beyond which those of all further harmonics are bounded together.
const MOST_COLUMNS: usize = 20 * HIGHEST_HARMONIC;

/// Checks a certificate. The numbers in it may be anything.
///
/// # Errors
/// [`NotProved`].
pub(super) fn prove(problem: DampedProblem) -> Result<Proof, NotProved> {
    if problem.odd && !problem.is_odd()? {
        return Err(NotProved::NotOdd);
    }
    let system = DampedBoundData::new(problem)?;
    let problem = &system.equations.problem;
    let curved = Curved::new(problem)?;
    let defect = system.defect();
    let contraction = system.contraction(&system.equations.derivative()?)?;
    let curvature = |within: Bound| {
        Ok(system.curvature(curved.norms(problem, &problem.ball(ROUGH, within))?, within))
    };
    let distinct = |radius: Bound| problem.is_distinct(radius, system.inverse.sigma);
    radius(defect, contraction, curvature, distinct)
}

/// The Newton correction: subtracted from p and the harmonics of a certificate, it brings them
/// nearer to the solution. It proves nothing.
///
/// # Errors
/// As [`prove`].
pub(super) fn correction(problem: DampedProblem) -> Result<Correction<CoordinateWave>, NotProved> {
    Ok(DampedBoundData::new(problem)?.correction())
}

/// The approximate derivative on the block, row by row, for steps that need no proof.
///
/// # Errors
/// As [`prove`].
pub(super) fn derivative_of_block(problem: DampedProblem) -> Result<Vec<Vec<f64>>, NotProved> {
    let equations = DampedEquations::new(problem)?;
    let derivative = equations.derivative()?;
    let entry = |row: CoordinateWave, place: usize| match place < equations.unknowns_before_waves()
    {
        true => WORKING.nearest(&equations.by_reciprocal(row)),
        false => SHORT.nearest(&derivative.entry(row, equations.block[place])),
    };
    let row =
        |row: &CoordinateWave| (0..equations.block.len()).map(|place| entry(*row, place)).collect();
    Ok(equations.block.iter().map(row).collect())
}

/// The expressions whose norms over a ball are in Z2.
struct Curved {
    damping: Vec<Vec<Expr>>,
    /// For each equation all derivatives of its row of the damping.
    slopes_of_damping: Vec<Vec<Expr>>,
    forces: Vec<Vec<Expr>>,
    slopes: Vec<Vec<Expr>>,
    /// For each equation all second derivatives of its force.
    bends: Vec<Vec<Expr>>,
}

impl Curved {
    fn new(problem: &DampedProblem) -> Result<Self, ExprError> {
        let of_row = |row: &[Expr]| -> Result<Vec<Expr>, ExprError> {
            Ok(problem.slopes(row)?.into_iter().flatten().collect())
        };
        let damping: Vec<Vec<Expr>> = problem
            .damping
            .iter()
            .map(|row| row.iter().map(|entry| (*entry).clone()).collect())
            .collect();
        let slopes = problem.slopes(&problem.forces)?;
        let all = |matrix: &[Vec<Expr>]| -> Result<Vec<Vec<Expr>>, ExprError> {
            matrix.iter().map(|row| of_row(row)).collect()
        };
        Ok(Self {
            slopes_of_damping: all(&damping)?,
            damping,
            forces: problem.forces.iter().map(|force| vec![(*force).clone()]).collect(),
            bends: all(&slopes)?,
            slopes,
        })
    }

    /// The norms of G, G', h, h', h'' over these motions: of each the largest sum over the equations.
    fn norms(
        &self,
        problem: &DampedProblem,
        motions: &[FourierSeries],
    ) -> Result<[Bound; 5], NoValue> {
        let all = [&self.damping, &self.slopes_of_damping, &self.forces, &self.slopes, &self.bends];
        let mut norms = [Bound::ZERO; 5];
        for (norm, matrix) in norms.iter_mut().zip(all) {
            *norm = largest_column(&problem.matrix_along(matrix, motions)?, FourierSeries::norm);
        }
        Ok(norms)
    }
}

/// A function that multiplies another: `s_m` and `t_m`, its coefficients as those of exponentials.
struct Multiplier {
    cosines: Vec<Ball>,
    sines: Vec<Ball>,
}

impl Multiplier {
    fn new(series: &FourierSeries) -> Self {
        let halved = |(k, ball): (usize, &Ball)| {
            let half = if k == 0 { ball.clone() } else { WORKING.divided(ball, 2) };
            SHORT.converted(&half, WORKING)
        };
        let halves = |balls: &[Ball]| balls.iter().enumerate().map(halved).collect();
        Self { cosines: halves(&series.cosines), sines: halves(&series.sines) }
    }

    /// The coefficient of one wave in the product with another.
    fn coefficient(&self, row: BasisFunction, column: BasisFunction) -> Ball {
        let cosine = |m: usize| self.cosines.get(m).cloned().unwrap_or_else(Ball::zero);
        let sine = |m: usize| match m {
            0 => Ball::zero(),
            _ => self.sines.get(m).cloned().unwrap_or_else(Ball::zero),
        };
        let (k, j) = (row.harmonic(), column.harmonic());
        let apart = |negative: bool| match negative {
            true => SHORT.scaled(&sine(k.abs_diff(j)), -1),
            false => sine(k.abs_diff(j)),
        };
        let both = match (row, column) {
            (BasisFunction::Cosine(_), BasisFunction::Cosine(_)) => {
                SHORT.sum(&cosine(k.abs_diff(j)), &cosine(k + j))
            }
            (BasisFunction::Sine(_), BasisFunction::Sine(_)) => {
                SHORT.difference(&cosine(k.abs_diff(j)), &cosine(k + j))
            }
            (BasisFunction::Sine(_), BasisFunction::Cosine(_)) => {
                SHORT.sum(&apart(k < j), &sine(k + j))
            }
            (BasisFunction::Cosine(_), BasisFunction::Sine(_)) => {
                SHORT.sum(&apart(j < k), &sine(k + j))
            }
        };
        // For the constant the two terms coincide.
        if k == 0 { SHORT.divided(&both, 2) } else { both }
    }
}

/// The derivative of F by the motion, at the approximate one.
struct Derivative {
    /// p.
    reciprocal: Ball,
    /// p^2.
    squared: Ball,
    /// G(X).
    damping: SeriesMatrix,
    /// h'(X).
    slopes: SeriesMatrix,
    by_damping: Vec<Vec<Multiplier>>,
    by_slopes: Vec<Vec<Multiplier>>,
}

impl Derivative {
    /// Number of harmonics that G(X) or h'(X) have, the larger of the two.
    fn width(&self) -> usize {
        let all = self.damping.iter().chain(&self.slopes).flatten();
        all.map(FourierSeries::length).max().unwrap_or(0)
    }

    /// The coefficient of one wave in `p (G e)' + p^2 h' e` of another, e.
    fn bent(&self, row: CoordinateWave, column: CoordinateWave) -> Ball {
        let k = row.harmonic() as i64;
        let [by_damping, by_slope] = [&self.by_damping, &self.by_slopes]
            .map(|matrix| &matrix[row.coordinate][column.coordinate]);
        // (cos)' = -k sin, (sin)' = k cos.
        let drag = match row.function {
            BasisFunction::Cosine(harmonic) => SHORT
                .scaled(&by_damping.coefficient(BasisFunction::Sine(harmonic), column.function), k),
            BasisFunction::Sine(harmonic) => SHORT.scaled(
                &by_damping.coefficient(BasisFunction::Cosine(harmonic), column.function),
                -k,
            ),
        };
        SHORT.sum(
            &SHORT.product(&self.reciprocal, &drag),
            &SHORT.product(&self.squared, &by_slope.coefficient(row.function, column.function)),
        )
    }

    /// The entry of the derivative, `e'' + p (G e)' + p^2 h' e`: that of [`Self::bent`] and on the
    /// diagonal `-k^2` of `e''`.
    fn entry(&self, row: CoordinateWave, column: CoordinateWave) -> Ball {
        let bent = self.bent(row, column);
        match row == column {
            true => SHORT.difference(&bent, &SHORT.integer(i64::from(row.squared()))),
            false => bent,
        }
    }
}

/// F at the approximate motion.
struct DampedEquations<'a> {
    problem: DampedProblem<'a>,
    /// p^2.
    squared: Ball,
    /// G(X) X'.
    drag: Vec<FourierSeries>,
    /// h(X).
    forces: Vec<FourierSeries>,
    /// The equations of the block, the sine of the first harmonic first. Among the unknowns p takes
    /// the place of that sine.
    block: Vec<CoordinateWave>,
}

impl<'a> DampedEquations<'a> {
    fn new(problem: DampedProblem<'a>) -> Result<Self, NotProved> {
        let motions = &problem.motions;
        let velocities: Vec<FourierSeries> =
            motions.iter().map(FourierSeries::derivative).collect();
        let drag = |row: &Vec<FourierSeries>| image_of(row, &velocities);
        let damping = problem.matrix_along(&problem.damping, motions)?;
        let force = |force: &&Expr| problem.values_along(force, motions);
        Ok(Self {
            squared: WORKING.product(&problem.reciprocal, &problem.reciprocal),
            drag: damping.iter().map(drag).collect(),
            forces: problem.forces.iter().map(force).collect::<Result<_, _>>()?,
            block: problem.block(),
            problem,
        })
    }

    /// Number of unknowns in front of the Fourier coefficients: one if p is an unknown, otherwise
    /// zero.
    fn unknowns_before_waves(&self) -> usize {
        usize::from(self.problem.is_free())
    }

    fn derivative(&self) -> Result<Derivative, NotProved> {
        let problem = &self.problem;
        let rough = |matrix: SeriesMatrix| -> SeriesMatrix {
            let row = |row: Vec<FourierSeries>| {
                row.into_iter().map(|series| series.shortened(ROUGH)).collect()
            };
            matrix.into_iter().map(row).collect()
        };
        let multipliers = |matrix: &SeriesMatrix| {
            matrix.iter().map(|row| row.iter().map(Multiplier::new).collect()).collect()
        };
        let damping = rough(problem.matrix_along(&problem.damping, &problem.motions)?);
        let slopes = problem.slopes(&problem.forces)?;
        let slopes = rough(problem.matrix_along(&slopes, &problem.motions)?);
        Ok(Derivative {
            reciprocal: SHORT.converted(&problem.reciprocal, WORKING),
            squared: SHORT.converted(&self.squared, WORKING),
            by_damping: multipliers(&damping),
            by_slopes: multipliers(&slopes),
            damping,
            slopes,
        })
    }

    /// The waves of all coordinates of the harmonics from one beyond the block up to another.
    fn beyond(&self, from: usize, to: usize) -> impl Iterator<Item = CoordinateWave> {
        let (step, highest) = (self.problem.step(), self.problem.highest);
        let from = from.max(highest + 1);
        let harmonics = (highest + step..=to).step_by(step).skip_while(move |k| *k < from);
        self.problem.waves(harmonics)
    }

    /// `p D_k + p^2 h_k`.
    fn bent(&self, wave: CoordinateWave) -> Ball {
        WORKING.sum(
            &WORKING.product(&self.problem.reciprocal, &wave.of(&self.drag)),
            &WORKING.product(&self.squared, &wave.of(&self.forces)),
        )
    }

    /// `D_k + 2 p h_k`, the derivative by p.
    fn by_reciprocal(&self, wave: CoordinateWave) -> Ball {
        let twice =
            WORKING.scaled(&WORKING.product(&self.problem.reciprocal, &wave.of(&self.forces)), 2);
        WORKING.sum(&wave.of(&self.drag), &twice)
    }

    /// The last harmonic that any of the series has.
    fn last(&self) -> usize {
        let all = self.problem.motions.iter().chain(&self.drag).chain(&self.forces);
        all.map(FourierSeries::length).max().unwrap_or(0)
    }

    /// The sum of the truncated parts of G(X) X', and that of h(X).
    fn tails(&self) -> [Bound; 2] {
        [&self.drag, &self.forces].map(|series| series.iter().map(|series| series.tail).sum())
    }
}

/// The quantities from which the bounds Y0, Z1 and Z2 are computed.
struct DampedBoundData<'a> {
    equations: DampedEquations<'a>,
    inverse: Inverse,
    /// alpha.
    size: Bound,
    /// beta.
    size_of_derivative: Bound,
}

impl<'a> DampedBoundData<'a> {
    fn new(problem: DampedProblem<'a>) -> Result<Self, NotProved> {
        // Without p among the unknowns all weigh the same.
        let sigma = if problem.is_free() { problem.sigma } else { 0 };
        let inverse = Inverse::from_entries(problem.inverse, problem.inverse_bits, sigma);
        let next = (problem.highest + 1) as f64;
        let equations = DampedEquations::new(problem)?;
        let beyond = Bound::exactly(1.0).over(next);
        let (mut size, mut size_of_derivative) = (beyond.over(next), beyond);
        for (column, wave) in equations.block.iter().enumerate() {
            let norm = inverse.norm_of_column(column);
            size = size.max(norm);
            size_of_derivative =
                size_of_derivative.max(norm * Bound::exactly(wave.harmonic() as f64));
        }
        Ok(Self { equations, inverse, size, size_of_derivative })
    }

    /// `B F`: the correction of p and of every harmonic, the amount by which the approximation is
    /// off.
    fn correction(&self) -> Correction<CoordinateWave> {
        let beyond = self.equations.beyond(0, self.equations.last()).map(|wave| {
            let image = WORKING.divided(&self.equations.bent(wave), wave.squared());
            (wave, WORKING.difference(&wave.of(&self.equations.problem.motions), &image))
        });
        let vector: Vec<Ball> = self
            .equations
            .block
            .iter()
            .map(|&wave| {
                let place = wave.of(&self.equations.problem.motions);
                let inertia = WORKING.scaled(&place, -i64::from(wave.squared()));
                WORKING.sum(&inertia, &self.equations.bent(wave))
            })
            .collect();
        Correction { block: self.inverse.image(&vector, WORKING), beyond: beyond.collect() }
    }

    /// Y0.
    fn defect(&self) -> Bound {
        let correction = self.correction();
        let beyond: Bound = correction.beyond.iter().map(|(_, y)| WORKING.magnitude(y)).sum();
        let [drag, forces] = self.equations.tails();
        let unseen = WORKING.magnitude(&self.equations.problem.reciprocal) * drag
            + WORKING.magnitude(&self.equations.squared) * forces;
        self.inverse.norm(&correction.block, WORKING) + beyond + self.size * unseen
    }

    /// Z1.
    fn contraction(&self, derivative: &Derivative) -> Result<Bound, NotProved> {
        let one = Bound::exactly(1.0);
        let [reciprocal, squared] = [&self.equations.problem.reciprocal, &self.equations.squared]
            .map(|ball| WORKING.magnitude(ball));
        let (highest, width) = (self.equations.problem.highest, derivative.width());
        let [damping, slopes] = [&derivative.damping, &derivative.slopes]
            .map(|matrix| largest_column(matrix, |series| series.tail));
        let unseen = self.size_of_derivative * reciprocal * damping + self.size * squared * slopes;
        let mut largest = match self.equations.problem.is_free() {
            true => self.column_of_reciprocal(),
            false => Bound::ZERO,
        };
        let waves_from = self.equations.unknowns_before_waves();
        let in_block = self.equations.block.iter().enumerate().skip(waves_from);
        let in_block = in_block.map(|(place, wave)| (*wave, Some(place)));
        // Columns with entries in the block, first where g and h' couple them to it, then beyond.
        let near = self.equations.beyond(0, highest + width).map(|wave| (wave, None));
        for (wave, place) in in_block.chain(near) {
            largest = largest.max(self.column(derivative, wave, place));
            if largest + unseen >= one {
                return Err(NotProved::NoContraction(largest + unseen));
            }
        }
        let [damping, slopes] = [&derivative.damping, &derivative.slopes]
            .map(|matrix| largest_column(matrix, FourierSeries::finite_norm));
        let mut upto = highest + width;
        let rest = loop {
            let far = (upto + 1 - width) as f64;
            let rest = (reciprocal * damping).over(far) + (squared * slopes).over(far * far);
            if rest < Bound::exactly(0.2) || rest < largest {
                break rest;
            }
            if upto > MOST_COLUMNS {
                return Err(NotProved::NoContraction(rest));
            }
            upto += self.equations.problem.step();
        };
        for wave in self.equations.beyond(highest + width + 1, upto) {
            largest = largest.max(self.column(derivative, wave, None));
        }
        Ok(largest.max(rest) + unseen)
    }

    /// The column of p.
    fn column_of_reciprocal(&self) -> Bound {
        let tail: Bound = self
            .equations
            .beyond(0, self.equations.last())
            .map(|wave| {
                WORKING.magnitude(
                    &WORKING.divided(&self.equations.by_reciprocal(wave), wave.squared()),
                )
            })
            .sum();
        let vector = self.equations.block.iter();
        let vector: Vec<Ball> = vector
            .map(|&wave| SHORT.converted(&self.equations.by_reciprocal(wave), WORKING))
            .collect();
        let twice = WORKING.magnitude(&self.equations.problem.reciprocal)
            + WORKING.magnitude(&self.equations.problem.reciprocal);
        let [drag, forces] = self.equations.tails();
        let unseen = self.size * (drag + twice * forces);
        (self.inverse.distance_from_unit(&vector, Some(0)) + tail + unseen)
            .over(self.inverse.sigma.value())
    }

    /// The column of a wave, in the block at this place or beyond it.
    fn column(
        &self,
        derivative: &Derivative,
        column: CoordinateWave,
        place: Option<usize>,
    ) -> Bound {
        let (j, width) = (column.harmonic(), derivative.width());
        let tail: Bound = self
            .equations
            .beyond((j + 1).saturating_sub(width), j + width)
            .map(|row| {
                SHORT.magnitude(&SHORT.divided(&derivative.bent(row, column), row.squared()))
            })
            .sum();
        // Far beyond the block, g and h' do not couple a wave to it.
        if j > self.equations.problem.highest + width {
            return tail;
        }
        let vector: Vec<Ball> =
            self.equations.block.iter().map(|row| derivative.entry(*row, column)).collect();
        self.inverse.distance_from_unit(&vector, place) + tail
    }

    /// Z2 on the ball of this radius, with the norms of G, G', h, h', h'' over it.
    fn curvature(
        &self,
        [damping, its_slope, force, slope, bend]: [Bound; 5],
        radius: Bound,
    ) -> Bound {
        let sigma = self.inverse.sigma.value();
        let (size, steep) = (self.size, self.size_of_derivative);
        let known = WORKING.magnitude(&self.equations.problem.reciprocal);
        let both_of_motion = |reciprocal: Bound| {
            steep * reciprocal * its_slope + size * reciprocal * reciprocal * bend
        };
        if !self.equations.problem.is_free() {
            return both_of_motion(known);
        }
        let reciprocal = known + radius.over(sigma);
        let twice = |bound: Bound| bound + bound;
        let both_of_reciprocal = twice(size * force).over(sigma).over(sigma);
        let one_of_each = (steep * damping + twice(reciprocal * size * slope)).over(sigma);
        both_of_reciprocal.max(one_of_each).max(both_of_motion(reciprocal))
    }
}

#[cfg(test)]
mod tests {
    use super::super::candidate::{certify_cycle, certify_driven, proved_by_some_block};
    use super::super::coupled::tests::{CYCLE_OF_MASSES, POTENTIAL_DAMPING, certified};
    use super::super::{CoupledCertificate, DampedCertificate, check_damped};
    use super::*;
    use crate::exact::{Integer, ratio};
    use crate::expr::parse_expression;
    use crate::numeric::ode::root::{BisectionStop, bisect};
    use crate::{Options, Oscillator, solve};

    fn certificate() -> DampedCertificate {
        let oscillator = Oscillator::parse("x'' - mu*(1 - x^2)*x' + x = 0").expect("an equation");
        let options = Options { order: Some(2), ..Options::default() };
        let solution = solve(&oscillator, &options).expect("a solution");
        let at = "mu = 1/2".parse().expect("values");
        certify_cycle(&oscillator, &solution, &at).expect("a certificate").0
    }

    /// A cycle nearby, of an equation that is neither odd nor one of polynomials.
    fn skew() -> DampedCertificate {
        let mut certificate = certificate();
        let with =
            |force: &Expr, more: &str| force + &parse_expression(more).expect("an expression");
        certificate.damping = with(&certificate.damping, "exp(-x/2)/10 + x/5");
        certificate.force = with(&certificate.force, "sin(x)/10 + x^2/20");
        certificate.odd = false;
        certificate.formula = None;
        // Few digits, for series of functions of many take their time.
        const LESS: usize = 64;
        certificate.bits -= LESS;
        certificate.reciprocal = certificate.reciprocal.clone() >> LESS;
        for list in [&mut certificate.cosines, &mut certificate.sines] {
            list.iter_mut().for_each(|units| *units = units.clone() >> LESS);
        }
        proved_by_some_block(&mut certificate, 30).expect("a proof");
        certificate
    }

    /// A driven motion of an equation that is neither odd nor one of polynomials, with two waves,
    /// one of them before x.
    fn driven() -> DampedCertificate {
        let oscillator =
            Oscillator::parse("x'' + x'/5 + x + x^3/10 - cos(Omega*t)/2 = 0").expect("an equation");
        let solution = solve(&oscillator, &Options::default()).expect("a solution");
        let at = "Omega = 6/5".parse().expect("values");
        let (mut certificate, _) =
            certify_driven(&oscillator, &solution, &at).expect("a certificate");
        let with =
            |force: &Expr, more: &str| force + &parse_expression(more).expect("an expression");
        certificate.damping = with(&certificate.damping, "exp(-x/2)/20 + x/20");
        certificate.force = with(&certificate.force, "sin(x)/20 + x^2/40 + x*s/20 - c*s/10");
        certificate.odd = false;
        certificate.formula = None;
        const LESS: usize = 64;
        certificate.bits -= LESS;
        for list in [&mut certificate.cosines, &mut certificate.sines] {
            list.iter_mut().for_each(|units| *units = units.clone() >> LESS);
        }
        proved_by_some_block(&mut certificate, 20).expect("a proof");
        certificate
    }

    /// A driven motion of two coordinates, whose dampings depend on both.
    fn coupled() -> CoupledCertificate {
        certified(POTENTIAL_DAMPING, "Omega = 4/5").0
    }

    /// A limit cycle of two coordinates likewise.
    fn coupled_cycle() -> CoupledCertificate {
        certified(CYCLE_OF_MASSES, "").0
    }

    #[test]
    fn equations_that_are_not_of_polynomials() {
        let certificate = skew();
        let certified = check_damped(&certificate).expect("a proof");
        let equation = "x'' + x'*(-1/2 + x^2/2 + exp(-x/2)/10 + x/5) + x + sin(x)/10 + x^2/20 = 0";
        let truth = followed(equation);
        let omega = WORKING.nearest(&WORKING.fraction(&certified.frequency.middle));
        assert!((omega / truth - 1.0).abs() < 1e-8, "{omega}, {truth}");
        assert!(certified.proof.radius.value() < 1e-10, "{certified:?}");
    }

    /// omega of the cycle that a motion ends on, from the times at which it goes upwards through
    /// zero.
    fn followed(equation: &str) -> f64 {
        let oscillator = Oscillator::parse(equation).expect("an equation");
        let force = crate::expr::CompiledFunction::new(
            &oscillator.force,
            &[oscillator.coordinate, oscillator.velocity()],
        )
        .expect("a function");
        let field = |[x, v]: [f64; 2]| [v, -force.call(&[x, v])];
        let step = |[x, v]: [f64; 2], h: f64| {
            let at = |k: [f64; 2], part: f64| [x + part * h * k[0], v + part * h * k[1]];
            let a = field([x, v]);
            let b = field(at(a, 0.5));
            let c = field(at(b, 0.5));
            let d = field(at(c, 1.0));
            let sum = |i: usize| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0;
            [x + h * sum(0), v + h * sum(1)]
        };
        let (mut state, mut t, mut crossings) = ([2.0, 0.0], 0.0, vec![]);
        while t < 150.0 {
            const STEP: f64 = 1.0 / 512.0;
            let next = step(state, STEP);
            if state[0] < 0.0 && next[0] >= 0.0 {
                let [part, _] = bisect(
                    |part| step(state, part)[0] < 0.0,
                    0.0,
                    STEP,
                    BisectionStop::Halvings(60),
                );
                crossings.push(t + part);
            }
            (state, t) = (next, t + STEP);
        }
        let last = &crossings[crossings.len() - 6..];
        std::f64::consts::TAU * 5.0 / (last[5] - last[0])
    }

    /// The cosine or sine of a harmonic.
    fn wave(wave: BasisFunction) -> FourierSeries {
        let mut balls = vec![Ball::zero(); wave.harmonic()];
        balls.push(WORKING.integer(1));
        match wave {
            BasisFunction::Cosine(_) => FourierSeries::exactly(balls, vec![]),
            BasisFunction::Sine(_) => FourierSeries::exactly(vec![], balls),
        }
    }

    /// F at a motion and p, as the products of series that it is.
    struct Place {
        damping: SeriesMatrix,
        slopes: SeriesMatrix,
        by_reciprocal: Vec<FourierSeries>,
        reciprocal: FourierSeries,
    }

    impl Place {
        fn of(problem: &DampedProblem, motions: &[FourierSeries], reciprocal: &Ball) -> Self {
            let slopes = problem.slopes(&problem.forces).expect("slopes");
            let reciprocal = FourierSeries::constant(reciprocal.clone());
            let damping = problem.matrix_along(&problem.damping, motions).expect("values");
            let slopes = problem.matrix_along(&slopes, motions).expect("values");
            let rates: Vec<FourierSeries> = motions.iter().map(FourierSeries::derivative).collect();
            let by_reciprocal = |(row, force): (&Vec<FourierSeries>, &&Expr)| {
                let force = problem.values_along(force, motions).expect("a value");
                image_of(row, &rates).sum(&reciprocal.product(&force).scaled(2))
            };
            Self {
                by_reciprocal: damping.iter().zip(&problem.forces).map(by_reciprocal).collect(),
                slopes,
                damping,
                reciprocal,
            }
        }

        /// DF on a direction, `None` that of p.
        fn derivative(&self, direction: Option<CoordinateWave>) -> Vec<FourierSeries> {
            let Some(CoordinateWave { coordinate, function }) = direction else {
                return self.by_reciprocal.clone();
            };
            let direction = wave(function);
            let equation = |row: usize| {
                let drag = self.damping[row][coordinate].product(&direction);
                let drag = drag.without_tail().derivative();
                let slope = self.slopes[row][coordinate].product(&direction);
                let bent = self.reciprocal.product(&drag.sum(&self.reciprocal.product(&slope)));
                match row == coordinate {
                    true => direction.derivative().derivative().sum(&bent),
                    false => bent,
                }
            };
            (0..self.damping.len()).map(equation).collect()
        }
    }

    /// The place of a wave among the unknowns of the block.
    fn place_of(system: &DampedBoundData, wave: CoordinateWave) -> Option<usize> {
        let first = system.equations.unknowns_before_waves();
        let mut waves = system.equations.block[first..].iter();
        waves.position(|other| *other == wave).map(|place| place + first)
    }

    /// The norm of B of a series, less a direction.
    fn size_of_image(
        system: &DampedBoundData,
        series: &[FourierSeries],
        less: Option<Option<CoordinateWave>>,
    ) -> f64 {
        let block = &system.equations.block;
        let vector: Vec<Ball> = block.iter().map(|wave| wave.of(series)).collect();
        let mut image = system.inverse.image(&vector, WORKING);
        let place = |direction: Option<CoordinateWave>| match direction {
            None => Some(0),
            Some(direction) => place_of(system, direction),
        };
        let mut beyond = 0.0;
        let last = series.iter().map(FourierSeries::length).max().unwrap_or(0);
        for row in system.equations.beyond(0, last) {
            let own = if less == Some(Some(row)) { 1.0 } else { 0.0 };
            beyond += (-WORKING.nearest(&row.of(series)) / f64::from(row.squared()) - own).abs();
        }
        if let Some(place) = less.and_then(place) {
            image[place] = WORKING.difference(&image[place], &WORKING.integer(1));
        }
        beyond + system.inverse.norm(&image, WORKING).value()
    }

    /// Every direction up to a harmonic, that of p first, where it is one; with the weight that it
    /// has in the norm.
    fn directions(system: &DampedBoundData, highest: usize) -> Vec<(Option<CoordinateWave>, f64)> {
        let first = system.equations.unknowns_before_waves();
        let block = system.equations.block[first..].iter().copied();
        let waves = block.chain(system.equations.beyond(0, highest)).map(|wave| (Some(wave), 1.0));
        let reciprocal = (first > 0).then(|| (None, system.inverse.sigma.value()));
        reciprocal.into_iter().chain(waves).collect()
    }

    /// Every column of `1 - B DF` by its definition, that of p first.
    fn columns(system: &DampedBoundData, highest: usize) -> Vec<(Option<CoordinateWave>, f64)> {
        let equations = &system.equations;
        let place = Place::of(
            &equations.problem,
            &equations.problem.motions,
            &equations.problem.reciprocal,
        );
        let column = |(direction, weight)| {
            let image = place.derivative(direction);
            (direction, size_of_image(system, &image, Some(direction)) / weight)
        };
        directions(system, highest).into_iter().map(column).collect()
    }

    #[test]
    fn no_column_is_larger_than_its_bound() {
        for sound in [certificate(), skew(), driven()] {
            let mut spoilt = sound.clone();
            for row in &mut spoilt.inverse {
                row[3] = &row[3] * Integer::from(3) / Integer::from(2);
            }
            let mut light = sound.clone();
            match light.drive {
                None => light.sigma = -34,
                Some(_) => light = spoilt.clone(),
            }
            for (certificate, is_proved) in [(&sound, true), (&spoilt, false), (&light, false)] {
                columns_are_bounded(certificate.problem(), is_proved);
            }
        }
        for sound in [coupled(), coupled_cycle()] {
            let mut spoilt = sound.clone();
            for row in &mut spoilt.inverse {
                row[3] = &row[3] * Integer::from(3) / Integer::from(2);
            }
            columns_are_bounded(sound.problem(), true);
            columns_are_bounded(spoilt.problem(), false);
        }
    }

    fn columns_are_bounded(problem: DampedProblem, is_proved: bool) {
        let last = 3 * problem.highest + 90;
        let system = DampedBoundData::new(problem).expect("a system");
        let derivative = system.equations.derivative().expect("a derivative");
        let contraction = system.contraction(&derivative).map_or(f64::INFINITY, Bound::value);
        assert_eq!(contraction < 0.5, is_proved, "{contraction}");
        for (direction, size) in columns(&system, last) {
            let bound = match direction {
                None => system.column_of_reciprocal(),
                Some(wave) => system.column(&derivative, wave, place_of(&system, wave)),
            };
            // The truncated part of g and h' is in the norm `size`, not in the column.
            assert!(size <= bound.value() + 1e-9, "{direction:?}: {size}, {bound:?}");
            assert!(size > 0.99 * bound.value() - 1e-9, "{direction:?}: {size}, {bound:?}");
            assert!(size <= contraction, "{direction:?}: {size}, {contraction}");
        }
    }

    #[test]
    fn what_a_series_leaves_out_counts() {
        let certificate = certificate();
        let more = Bound::exactly(0.001);
        let system = || DampedBoundData::new(certificate.problem()).expect("a system");
        let own = system();
        let size = own.size.value();
        let reciprocal = WORKING.nearest(&own.equations.problem.reciprocal);
        let squared = reciprocal * reciprocal;
        let (mut drag, mut force) = (system(), system());
        drag.equations.drag[0].tail += more;
        force.equations.forces[0].tail += more;
        for (wider, factor, of_reciprocal) in
            [(&drag, reciprocal, 1.0), (&force, squared, 2.0 * reciprocal)]
        {
            let by = wider.defect().value() - own.defect().value();
            assert!((by / (0.001 * size * factor) - 1.0).abs() < 1e-9, "{by}");
            let by = wider.column_of_reciprocal().value() - own.column_of_reciprocal().value();
            let expected = 0.001 * size * of_reciprocal / own.inverse.sigma.value();
            assert!((by / expected - 1.0).abs() < 1e-9, "{by}");
        }
        let derivative = || own.equations.derivative().expect("a derivative");
        let contraction =
            |derivative: &Derivative| own.contraction(derivative).expect("a contraction").value();
        let (mut damping, mut slope) = (derivative(), derivative());
        damping.damping[0][0].tail += more;
        slope.slopes[0][0].tail += more;
        let steep = own.size_of_derivative.value();
        for (wider, expected) in [(damping, steep * reciprocal), (slope, size * squared)] {
            let by = contraction(&wider) - contraction(&derivative());
            assert!((by / (0.001 * expected) - 1.0).abs() < 1e-9, "{by}");
        }
        // A harmonic beyond the block is off by itself.
        let mut shaken = certificate.clone();
        shaken.cosines[41] += Integer::from(1) << (shaken.bits - 20);
        let defect = DampedBoundData::new(shaken.problem()).expect("a system").defect().value();
        assert!((defect * f64::from(1 << 20) - 1.0).abs() < 0.2, "{defect}");
    }

    #[test]
    fn the_second_derivative_is_no_larger_than_its_bound() {
        second_derivative_is_bounded(skew().problem());
        second_derivative_is_bounded(driven().problem());
        second_derivative_is_bounded(coupled().problem());
        second_derivative_is_bounded(coupled_cycle().problem());
    }

    fn second_derivative_is_bounded(problem: DampedProblem) {
        let (h, within) = (Bound::power_of_two(-20), WORKING.fraction(&ratio(1, 1 << 20)));
        let last = problem.highest + 6;
        let system = DampedBoundData::new(problem).expect("a system");
        let problem = &system.equations.problem;
        let ball: Vec<FourierSeries> =
            problem.motions.iter().map(|motion| motion.clone().widened(h)).collect();
        let curved = Curved::new(problem).expect("derivatives");
        let [g, its_slope, f, slope, bend] = curved.norms(problem, &ball).expect("values");
        // Of two directions, none, one or both of them the motion's: each has terms of its own.
        let bounds = [
            [Bound::ZERO, Bound::ZERO, f, Bound::ZERO, Bound::ZERO],
            [g, Bound::ZERO, Bound::ZERO, slope, Bound::ZERO],
            [Bound::ZERO, its_slope, Bound::ZERO, Bound::ZERO, bend],
        ]
        .map(|norms| system.curvature(norms, h).value());
        let directions = directions(&system, last);
        let own = Place::of(
            &system.equations.problem,
            &system.equations.problem.motions,
            &system.equations.problem.reciprocal,
        );
        for (from, weight) in directions.iter().step_by(directions.len() / 7) {
            let mut motions = system.equations.problem.motions.clone();
            let mut reciprocal = system.equations.problem.reciprocal.clone();
            // So far that the norm of the step is h.
            match from {
                None => reciprocal = WORKING.sum(&reciprocal, &within),
                Some(CoordinateWave { coordinate, function }) => {
                    let step = wave(*function).product(&FourierSeries::constant(within.clone()));
                    motions[*coordinate] = motions[*coordinate].sum(&step);
                }
            }
            let moved = Place::of(&system.equations.problem, &motions, &reciprocal);
            for (along, other) in &directions {
                let change: Vec<FourierSeries> = moved
                    .derivative(*along)
                    .iter()
                    .zip(own.derivative(*along))
                    .map(|(moved, own)| moved.difference(&own))
                    .collect();
                let size = size_of_image(&system, &change, None) / (h.value() * weight * other);
                let bound = bounds[usize::from(from.is_some()) + usize::from(along.is_some())];
                assert!(size <= bound, "{from:?}, {along:?}: {size}, {bound}");
            }
        }
    }
}

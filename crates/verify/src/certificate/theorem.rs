//! The theorem: whether there is exactly one motion near an approximate one, and how near.
//!
//! For `q'' + f(q) = 0` of one coordinate or several, `q'(0) = 0`, and `q(t) = X(omega t)`,
//! `X_i(theta) = sum c_ik cos(k theta)`, `mu = 1/omega^2`:
//!
//! ```text
//! F_eta = sum_k c_sk - A             the condition: the start of one coordinate s,
//!      or sum_i p_i c_i1 - a         or the first harmonic of a sum of all
//! F_ik  = -k^2 c_ik + mu [f_i(c)]_k                                           the equations in harmonics, k <= N and beyond
//! Y0 >= ||B F(mu, c)||,       Z1 >= ||1 - B DF(mu, c)||,      Z2 >= Lipschitz constant of B DF on the ball of radius R
//! D = (1 - Z1)^2 - 2 Y0 Z2,   r = 2 Y0/((1 - Z1) + sqrt(D))                   norm: sigma |mu| + sum_ik |c_ik|
//! ```
//!
//! If `Z1 < 1`, `D > 0`, `r <= R`, `Z1 + Z2 r < 1`, `r/sigma < mu` and `r < |c_i1|` for some i, the
//! map `1 - B F` takes the ball of radius r about the approximation into itself and contracts there:
//! it holds exactly one solution, whose smallest period is `2 pi sqrt(mu)`. The approximate inverse
//! B is a matrix on `mu` and the harmonics up to N, and `-1/k^2` beyond, where the sum of the
//! corrections of the coordinate s enters the condition at `t = 0`; the condition on the first
//! harmonic feels none of them. With `alpha = ||B||` on the equations of the harmonics and norms over
//! the ball of radius R,
//!
//! ```text
//! Z2 = alpha max(max_j sum_i ||df_i/dq_j||/sigma, (mu + R/sigma) max_jl sum_i ||d^2 f_i/dq_j dq_l||)
//! ```
//!
//! bounds the second derivative of F, `(h, h') -> h_mu Df h'_c + h'_mu Df h_c + mu D^2 f h_c h'_c`.
//! Of one coordinate, whose start determines it, the solution is the only motion there is. Of several
//! it is the only one in the ball that begins at rest with this amplitude; where only odd harmonics are
//! sought, the only one of these. No input is trusted: any
//! numbers may be claimed, and every inequality is checked in balls.
//!
//! Source: S. Day, J.-P. Lessard, K. Mischaikow: Validated continuation for equilibria of PDEs,
//! SIAM Journal on Numerical Analysis 45 (2007), 1398-1424; J. B. van den Berg, J.-P. Lessard:
//! Rigorous numerics in dynamics, Notices of the AMS 62 (2015), 1057-1061. The cost is that of n^3
//! products of short integers, n the number of harmonics in the block times that of coordinates.

mod on_piece;

use num_traits::Signed as _;

use super::HIGHEST_HARMONIC;
use super::approximate_inverse::{Inverse, SHORT};
use super::force::{NoValue, along_all, is_odd};
use super::fourier_series::{FourierSeries, WORKING};
use super::radii_polynomial::{Correction, NotProved, Proof, radius};
use crate::exact::Integer;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::expr::{Expr, ExprError};
use crate::symbol::Symbol;
pub(super) use on_piece::{ApproximateMotion, ApproximateMotions, MotionsOnPiece, NearMotion};

/// Columns beyond which those of all further harmonics are bounded together.
const MOST_COLUMNS: usize = 20 * HIGHEST_HARMONIC;

/// The definition of the amplitude of a motion that begins at rest.
#[derive(Clone)]
pub(super) enum Condition {
    /// A coordinate starts at this place.
    Start { coordinate: usize, place: Ball },
    /// The sum of the coordinates, each with its factor, has a first harmonic of this amplitude.
    FirstHarmonic { factors: Vec<Ball>, amplitude: Ball },
}

/// A certificate in the form that the theorem takes, of one coordinate or several.
#[derive(Clone)]
pub(super) struct ConservativeProblem<'a> {
    /// f, one for each coordinate.
    pub(super) forces: Vec<&'a Expr>,
    /// The symbols of the coordinates.
    pub(super) coordinates: Vec<Symbol>,
    /// A letter of the forces beside the coordinates, and the numbers that it stands for.
    pub(super) parameter: Option<(Symbol, Ball)>,
    /// The definition of the amplitude.
    pub(super) condition: Condition,
    /// Whether the motion has odd harmonics alone.
    pub(super) odd: bool,
    /// X, approximately, one series for each coordinate.
    pub(super) motions: Vec<FourierSeries>,
    /// `1/omega^2`, approximately.
    pub(super) mu: Ball,
    /// The last harmonic of the block.
    pub(super) highest: usize,
    /// The entries of the inverse, in units of `2^-inverse_bits`.
    pub(super) inverse: &'a [Vec<Integer>],
    pub(super) inverse_bits: usize,
    /// The weight of mu is `2^sigma`.
    pub(super) sigma: i32,
}

/// A harmonic of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CoordinateHarmonic {
    pub(super) coordinate: usize,
    pub(super) harmonic: usize,
}

impl CoordinateHarmonic {
    /// The square of its harmonic.
    fn squared(self) -> u32 {
        u32::try_from(self.harmonic * self.harmonic).unwrap_or(u32::MAX)
    }
}

impl ConservativeProblem<'_> {
    /// The step from one harmonic to the next.
    const fn step(&self) -> usize {
        if self.odd { 2 } else { 1 }
    }

    /// The harmonics of the block, coordinate by coordinate.
    pub(super) fn block(&self) -> Vec<CoordinateHarmonic> {
        let harmonics = (usize::from(self.odd)..=self.highest).step_by(self.step());
        let of = |coordinate| {
            harmonics.clone().map(move |harmonic| CoordinateHarmonic { coordinate, harmonic })
        };
        (0..self.coordinates.len()).flat_map(of).collect()
    }

    /// The values of an expression along motions of all coordinates.
    fn values_along(
        &self,
        expression: &Expr,
        motions: &[FourierSeries],
    ) -> Result<FourierSeries, NoValue> {
        let mut letters: Vec<(Symbol, &FourierSeries)> =
            self.coordinates.iter().copied().zip(motions).collect();
        let constant =
            |(name, value): &(Symbol, Ball)| (*name, FourierSeries::constant(value.clone()));
        let parameter = self.parameter.as_ref().map(constant);
        letters.extend(parameter.iter().map(|(name, value)| (*name, value)));
        along_all(expression, &letters)
    }

    /// The derivatives of the forces by the coordinates: a row for each force.
    fn slopes(&self) -> Result<Vec<Vec<Expr>>, ExprError> {
        let row = |force: &&Expr| {
            self.coordinates.iter().map(|name| force.differentiate(*name)).collect()
        };
        self.forces.iter().map(row).collect()
    }

    /// Whether the forces are odd and the motion has odd harmonics alone.
    pub(super) fn is_odd(&self) -> Result<bool, ExprError> {
        for force in &self.forces {
            if !is_odd(force, &self.coordinates)? {
                return Ok(false);
            }
        }
        let mut even = self.motions.iter().flat_map(|motion| motion.cosines.iter().step_by(2));
        Ok(even.all(Ball::is_zero))
    }

    /// What the condition says of a harmonic: the derivative by its coefficient.
    fn by_condition(&self, wave: CoordinateHarmonic) -> Option<Ball> {
        match &self.condition {
            Condition::Start { coordinate, .. } => {
                (*coordinate == wave.coordinate).then(|| WORKING.integer(1))
            }
            Condition::FirstHarmonic { factors, .. } => {
                (wave.harmonic == 1).then(|| factors[wave.coordinate].clone())
            }
        }
    }

    /// Whether the condition feels the harmonics of a coordinate beyond the block.
    fn reaches(&self, coordinate: usize) -> bool {
        matches!(&self.condition, Condition::Start { coordinate: own, .. } if *own == coordinate)
    }

    /// The amount by which the condition does not hold.
    fn off_condition(&self) -> Ball {
        match &self.condition {
            Condition::Start { coordinate, place } => {
                WORKING.difference(&self.motions[*coordinate].at_zero(), place)
            }
            Condition::FirstHarmonic { factors, amplitude } => {
                let parts = factors.iter().zip(&self.motions);
                let sum = parts.fold(Ball::zero(), |sum, (factor, motion)| {
                    WORKING.sum(&sum, &WORKING.product(factor, &motion.cosine(1)))
                });
                WORKING.difference(&sum, amplitude)
            }
        }
    }

    /// The amplitude of motions, by the left side of the condition.
    pub(super) fn condition_along(&self, directions: &[FourierSeries]) -> Ball {
        match &self.condition {
            Condition::Start { coordinate, .. } => directions[*coordinate].at_zero(),
            Condition::FirstHarmonic { factors, .. } => {
                factors.iter().zip(directions).fold(Ball::zero(), |sum, (factor, direction)| {
                    WORKING.sum(&sum, &WORKING.product(factor, &direction.cosine(1)))
                })
            }
        }
    }

    /// Whether no state of rest and no motion of a shorter period lies within this radius.
    fn is_distinct(&self, radius: Bound, sigma: Bound) -> bool {
        let first = |motion: &FourierSeries| WORKING.distance_from_zero(&motion.cosine(1));
        self.mu.middle.is_positive()
            && radius.over(sigma.value()).value() < WORKING.distance_from_zero(&self.mu)
            && radius.value() < self.motions.iter().map(first).fold(0.0, f64::max)
    }
}

/// Checks a certificate. The numbers in it may be anything.
///
/// # Errors
/// [`NotProved`].
pub(super) fn prove(problem: ConservativeProblem) -> Result<Proof, NotProved> {
    Theorem::new(problem)?.proof(Bound::ZERO)
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
    problem: ConservativeProblem,
    spread: Bound,
) -> Result<Neighbours, NotProved> {
    let theorem = Theorem::new(problem)?;
    let [of_middle, of_all] = [theorem.proof(Bound::ZERO)?, theorem.proof(spread)?];
    let sigma = theorem.system.inverse.sigma;
    let widened =
        |ball: &Ball, by: Bound| Ball { middle: ball.middle.clone(), radius: ball.radius + by };
    let (direction, left) = theorem.system.slope_by_condition(&theorem.slopes);
    let turned = of_all.curvature * of_all.radius;
    let contracts = (of_all.contraction + turned).below_complement();
    let harmonics: Bound = direction.harmonics.iter().map(FourierSeries::norm).sum();
    let size = sigma * WORKING.magnitude(&direction.mu) + harmonics;
    let apart = (left + turned * size).over(contracts);
    let around =
        |proof: &Proof| widened(&theorem.system.problem.mu, proof.radius.over(sigma.value()));
    Ok(Neighbours {
        mu: around(&of_all),
        mu_in_middle: around(&of_middle),
        slope: widened(&direction.mu, apart.over(sigma.value())),
    })
}

/// A direction of `mu` and the harmonics of all coordinates.
struct Direction {
    mu: Ball,
    harmonics: Vec<FourierSeries>,
}

impl Direction {
    /// Adds the middles of a correction.
    fn add(&mut self, correction: &Correction<CoordinateHarmonic>, block: &[CoordinateHarmonic]) {
        let added = |to: &Ball, ball: &Ball| Ball {
            middle: &to.middle + &ball.middle,
            radius: Bound::ZERO,
        };
        self.mu = added(&self.mu, &correction.block[0]);
        let in_block = block.iter().zip(&correction.block[1..]);
        for (wave, ball) in in_block.chain(correction.beyond.iter().map(|(wave, y)| (wave, y))) {
            let cosines = &mut self.harmonics[wave.coordinate].cosines;
            let k = wave.harmonic;
            cosines.resize(cosines.len().max(k + 1), Ball::zero());
            cosines[k] = added(&cosines[k], ball);
        }
    }
}

/// The bounds of a certificate from which its proofs follow.
struct Theorem<'a> {
    system: BoundData<'a>,
    slopes: Slopes,
    defect: Bound,
    contraction: Bound,
}

impl<'a> Theorem<'a> {
    fn new(problem: ConservativeProblem<'a>) -> Result<Self, NotProved> {
        if problem.odd && !problem.is_odd()? {
            return Err(NotProved::NotOdd);
        }
        let system = BoundData::new(problem)?;
        let slopes = Slopes::new(&system.problem)?;
        Ok(Self {
            defect: system.defect(),
            contraction: system.contraction(&slopes)?,
            slopes,
            system,
        })
    }

    /// The proof for every value of the condition within `spread`.
    fn proof(&self, spread: Bound) -> Result<Proof, NotProved> {
        let defect = self.defect + spread * self.system.start;
        let curvature = |within| {
            let [by_mu, by_motion] = self.system.curvature(&self.slopes.expressions, within)?;
            Ok(by_mu.max(by_motion))
        };
        let distinct =
            |radius: Bound| self.system.problem.is_distinct(radius, self.system.inverse.sigma);
        radius(defect, self.contraction, curvature, distinct)
    }
}

/// The Newton correction: subtracted from `mu` and the harmonics of a certificate, it brings them
/// nearer to the solution. It proves nothing.
///
/// # Errors
/// As [`prove`].
pub(super) fn correction(
    problem: ConservativeProblem,
) -> Result<Correction<CoordinateHarmonic>, NotProved> {
    Ok(BoundData::new(problem)?.correction())
}

/// The approximate derivative on the block, row by row, for steps that need no proof.
///
/// # Errors
/// As [`prove`].
pub(super) fn derivative_of_block(
    problem: &ConservativeProblem,
) -> Result<Vec<Vec<f64>>, NotProved> {
    let forces = forces_along(problem)?;
    let slopes = Slopes::new(problem)?;
    let mu = WORKING.nearest(&problem.mu);
    let nearest = |ball: Option<Ball>| ball.map_or(0.0, |ball| WORKING.nearest(&ball));
    let block = problem.block();
    let of_condition = block.iter().map(|wave| nearest(problem.by_condition(*wave)));
    let mut rows = vec![std::iter::once(0.0).chain(of_condition).collect::<Vec<f64>>()];
    for row in &block {
        let by_mu = WORKING.nearest(&forces[row.coordinate].cosine(row.harmonic));
        let by_harmonics = block.iter().map(|column| {
            let bent = mu * slopes.near(*row, *column);
            if row == column { bent - f64::from(row.squared()) } else { bent }
        });
        rows.push(std::iter::once(by_mu).chain(by_harmonics).collect());
    }
    Ok(rows)
}

/// The forces along the approximate motion.
fn forces_along(problem: &ConservativeProblem) -> Result<Vec<FourierSeries>, NoValue> {
    let along = |force: &&Expr| problem.values_along(force, &problem.motions);
    problem.forces.iter().map(along).collect()
}

/// A derivative `df_i/dq_j` along the motion, by which the derivative of F multiplies.
struct Slope {
    series: FourierSeries,
    /// Its coefficients by harmonic as those of exponentials, `s_0 = g_0`, `s_m = g_m/2`, and as
    /// doubles.
    halves: Vec<Ball>,
    doubles: Vec<f64>,
}

impl Slope {
    fn new(series: FourierSeries) -> Self {
        let halved = |(k, ball): (usize, &Ball)| {
            if k == 0 { ball.clone() } else { WORKING.divided(ball, 2) }
        };
        let double =
            |(k, ball): (usize, &Ball)| WORKING.nearest(ball) * if k == 0 { 1.0 } else { 0.5 };
        let cosines = || series.cosines.iter().enumerate();
        let (halves, doubles) = (cosines().map(halved).collect(), cosines().map(double).collect());
        Self { series, halves, doubles }
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

    /// The same coefficient as a double.
    fn near(&self, k: usize, j: usize) -> f64 {
        let half = |m: usize| self.doubles.get(m).copied().unwrap_or(0.0);
        match (k, j) {
            (0, 0) => half(0),
            (_, 0) => 2.0 * half(k),
            (0, _) => half(j),
            _ => half(k.abs_diff(j)) + half(k + j),
        }
    }
}

/// The derivatives of all forces by all coordinates.
struct Slopes {
    /// A row for each force.
    expressions: Vec<Vec<Expr>>,
    /// Their values along the approximate motion.
    values: Vec<Vec<Slope>>,
}

impl Slopes {
    fn new(problem: &ConservativeProblem) -> Result<Self, NotProved> {
        let expressions = problem.slopes()?;
        let value = |slope: &Expr| Ok(Slope::new(problem.values_along(slope, &problem.motions)?));
        let row = |row: &Vec<Expr>| row.iter().map(value).collect();
        let values = expressions.iter().map(row).collect::<Result<_, NoValue>>()?;
        Ok(Self { expressions, values })
    }

    /// The number of harmonics that the derivatives have.
    fn width(&self) -> usize {
        let lengths = self.values.iter().flatten().map(|slope| slope.series.cosines.len());
        lengths.max().unwrap_or(0)
    }

    /// The coefficient of a harmonic of a force in the image of a harmonic of a coordinate.
    fn coefficient(&self, row: CoordinateHarmonic, column: CoordinateHarmonic) -> Ball {
        self.values[row.coordinate][column.coordinate].coefficient(row.harmonic, column.harmonic)
    }

    /// The same coefficient as a double.
    fn near(&self, row: CoordinateHarmonic, column: CoordinateHarmonic) -> f64 {
        self.values[row.coordinate][column.coordinate].near(row.harmonic, column.harmonic)
    }

    /// The largest sum of a bound over the derivatives of all forces by one coordinate.
    fn largest_column(&self, bound: impl Fn(usize, &Slope) -> Bound) -> Bound {
        let column = |column: usize| -> Bound {
            self.values.iter().enumerate().map(|(force, row)| bound(force, &row[column])).sum()
        };
        (0..self.values.len()).map(column).fold(Bound::ZERO, Bound::max)
    }
}

/// The quantities from which the bounds Y0, Z1 and Z2 are computed.
struct BoundData<'a> {
    problem: ConservativeProblem<'a>,
    inverse: Inverse,
    /// `f(c)`.
    forces: Vec<FourierSeries>,
    /// The harmonics of the block.
    block: Vec<CoordinateHarmonic>,
    /// The norm of the column of the condition.
    start: Bound,
    /// The norm of the inverse on the equations of the harmonics.
    size: Bound,
}

impl<'a> BoundData<'a> {
    fn new(problem: ConservativeProblem<'a>) -> Result<Self, NotProved> {
        let forces = forces_along(&problem)?;
        let inverse = Inverse::from_entries(problem.inverse, problem.inverse_bits, problem.sigma);
        let block = problem.block();
        let start = inverse.norm_of_column(0);
        let columns = (1..=block.len()).map(|column| inverse.norm_of_column(column));
        let next = problem.highest + problem.step();
        let reached = (0..forces.len()).any(|coordinate| problem.reaches(coordinate));
        let felt = if reached { start } else { Bound::ZERO };
        let beyond = (Bound::exactly(1.0) + felt).over((next * next) as f64);
        let size = columns.fold(beyond, Bound::max);
        Ok(Self { problem, inverse, forces, block, start, size })
    }

    /// The harmonics from one up to another, of those that the motion may have.
    fn harmonics(&self, from: usize, to: usize) -> impl Iterator<Item = usize> + Clone + use<> {
        let (step, first) = (self.problem.step(), usize::from(self.problem.odd));
        let from = match from % step == first % step {
            true => from,
            false => from + 1,
        };
        (from..=to).step_by(step)
    }

    /// The harmonics of all coordinates from one up to another.
    fn waves(&self, from: usize, to: usize) -> impl Iterator<Item = CoordinateHarmonic> + use<> {
        let harmonics = self.harmonics(from, to);
        let of = move |coordinate| {
            harmonics.clone().map(move |harmonic| CoordinateHarmonic { coordinate, harmonic })
        };
        (0..self.forces.len()).flat_map(of)
    }

    /// The harmonics beyond the block, up to this one.
    fn beyond(&self, to: usize) -> impl Iterator<Item = CoordinateHarmonic> + use<> {
        self.waves(self.problem.highest + 1, to)
    }

    /// `f_k`.
    fn force(&self, wave: CoordinateHarmonic) -> Ball {
        self.forces[wave.coordinate].cosine(wave.harmonic)
    }

    /// The length of the longest of some series.
    fn longest(series: &[FourierSeries]) -> usize {
        series.iter().map(|series| series.cosines.len()).max().unwrap_or(0)
    }

    /// `B F`: the correction of `mu` and of every harmonic, the amount by which the approximation
    /// is off.
    fn correction(&self) -> Correction<CoordinateHarmonic> {
        let last = Self::longest(&self.problem.motions).max(Self::longest(&self.forces));
        self.image(self.problem.off_condition(), last, |wave| {
            let place = self.problem.motions[wave.coordinate].cosine(wave.harmonic);
            let inertia = WORKING.scaled(&place, -i64::from(wave.squared()));
            WORKING.sum(&inertia, &WORKING.product(&self.problem.mu, &self.force(wave)))
        })
    }

    /// B applied to the residuals: of the condition, and of the equations of the harmonics up to a
    /// given one.
    fn image(
        &self,
        mut start: Ball,
        last: usize,
        equation: impl Fn(CoordinateHarmonic) -> Ball,
    ) -> Correction<CoordinateHarmonic> {
        let mut beyond = vec![];
        for wave in self.beyond(last) {
            let y = WORKING.scaled(&WORKING.divided(&equation(wave), wave.squared()), -1);
            if self.problem.reaches(wave.coordinate) {
                start = WORKING.difference(&start, &y);
            }
            beyond.push((wave, y));
        }
        let mut vector = vec![start];
        vector.extend(self.block.iter().map(|&wave| equation(wave)));
        Correction { block: self.inverse.image(&vector, WORKING), beyond }
    }

    /// The norm of `mu` and harmonics.
    fn norm(&self, vector: &Correction<CoordinateHarmonic>) -> Bound {
        let beyond: Bound = vector.beyond.iter().map(|(_, y)| WORKING.magnitude(y)).sum();
        self.inverse.norm(&vector.block, WORKING) + beyond
    }

    /// The sum of the tails of the forces.
    fn tails(&self) -> Bound {
        self.forces.iter().map(|force| force.tail).sum()
    }

    /// Approximates the derivative of `mu` and the harmonics by the value of the condition by some
    /// v, and bounds `||B (e_eta - DF v)||`.
    fn slope_by_condition(&self, slopes: &Slopes) -> (Direction, Bound) {
        /// Steps of Newton's iteration, each of which gains the digits of Z1.
        const STEPS: usize = 6;
        let one = WORKING.integer(1);
        let nothing = FourierSeries::exactly(vec![], vec![]);
        let harmonics = vec![nothing.clone(); self.forces.len()];
        let mut direction = Direction { mu: Ball::zero(), harmonics };
        let mut step = 0;
        loop {
            let waves = &direction.harmonics;
            let along = |row: &Vec<Slope>| {
                let parts = row.iter().zip(waves).map(|(slope, wave)| slope.series.product(wave));
                parts.reduce(|sum, part| sum.sum(&part)).unwrap_or_else(|| nothing.clone())
            };
            let bent: Vec<FourierSeries> = slopes.values.iter().map(along).collect();
            let last = [&self.forces, &bent, waves].map(|series| Self::longest(series));
            let last = last.into_iter().max().unwrap_or(0);
            let start = WORKING.difference(&one, &self.problem.condition_along(waves));
            let left = self.image(start, last, |wave| {
                let (i, k) = (wave.coordinate, wave.harmonic);
                let inertia = WORKING.scaled(&waves[i].cosine(k), i64::from(wave.squared()));
                let moved = WORKING.sum(
                    &WORKING.product(&direction.mu, &self.force(wave)),
                    &WORKING.product(&self.problem.mu, &bent[i].cosine(k)),
                );
                WORKING.difference(&inertia, &moved)
            });
            if step == STEPS {
                let tails: Bound = bent.iter().map(|series| series.tail).sum();
                let unseen = WORKING.magnitude(&direction.mu) * self.tails()
                    + WORKING.magnitude(&self.problem.mu) * tails;
                let left = self.norm(&left) + self.size * unseen;
                return (direction, left);
            }
            direction.add(&left, &self.block);
            step += 1;
        }
    }

    /// Y0.
    fn defect(&self) -> Bound {
        let unseen = self.size * WORKING.magnitude(&self.problem.mu) * self.tails();
        self.norm(&self.correction()) + unseen
    }

    /// Z1.
    fn contraction(&self, slopes: &Slopes) -> Result<Bound, NotProved> {
        let mu = WORKING.magnitude(&self.problem.mu);
        let last = slopes.width();
        let highest = self.problem.highest;
        let mut largest = self.column_of_mu();
        for (index, &wave) in self.block.iter().enumerate() {
            largest = largest.max(self.column(slopes, wave, Some(index + 1)));
        }
        // Columns with entries in the block, where the coefficients of f' couple them to it, then
        // beyond.
        for wave in self.beyond(highest + last) {
            largest = largest.max(self.column(slopes, wave, None));
        }
        let all = slopes.largest_column(|force, slope| {
            let felt = if self.problem.reaches(force) { self.start } else { Bound::ZERO };
            mu * (Bound::exactly(1.0) + felt) * slope.series.finite_norm()
        });
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
            upto += self.problem.step();
        };
        for wave in self.waves(highest + last + 1, upto) {
            largest = largest.max(self.column(slopes, wave, None));
        }
        let tails = slopes.largest_column(|_, slope| slope.series.tail);
        Ok(largest.max(rest) + self.size * mu * tails)
    }

    /// The column of `mu`.
    fn column_of_mu(&self) -> Bound {
        let short = |ball: &Ball| SHORT.converted(ball, WORKING);
        let (mut start, mut tail) = (Ball::zero(), Bound::ZERO);
        for wave in self.beyond(Self::longest(&self.forces)) {
            let part = WORKING.divided(&self.force(wave), wave.squared());
            if self.problem.reaches(wave.coordinate) {
                start = WORKING.sum(&start, &part);
            }
            tail += WORKING.magnitude(&part);
        }
        let mut vector = vec![short(&start)];
        vector.extend(self.block.iter().map(|&wave| short(&self.force(wave))));
        let block = self.inverse.distance_from_unit(&vector, Some(0));
        (block + tail + self.size * self.tails()).over(self.inverse.sigma.value())
    }

    /// The column of a harmonic, in the block at this place or beyond it.
    fn column(&self, slopes: &Slopes, column: CoordinateHarmonic, place: Option<usize>) -> Bound {
        let (j, last) = (column.harmonic, slopes.width());
        let part = |row: CoordinateHarmonic| {
            WORKING.product(&self.problem.mu, &slopes.coefficient(row, column))
        };
        let (mut start, mut tail) = (Ball::zero(), Bound::ZERO);
        let from = (self.problem.highest + 1).max((j + 1).saturating_sub(last));
        for row in self.waves(from, j + last) {
            let image = WORKING.divided(&part(row), row.squared());
            if self.problem.reaches(row.coordinate) {
                start = WORKING.sum(&start, &image);
            }
            tail += WORKING.magnitude(&image);
        }
        // Far beyond the block, f' does not couple a harmonic to it; only the condition at t = 0
        // does.
        if j > self.problem.highest + last {
            return tail + self.start * WORKING.magnitude(&start);
        }
        if let Some(own) = self.problem.by_condition(column).filter(|_| place.is_some()) {
            start = WORKING.sum(&start, &own);
        }
        let mut vector = vec![SHORT.converted(&start, WORKING)];
        vector.extend(self.block.iter().map(|&row| {
            let mut entry = part(row);
            if row == column {
                entry = WORKING.difference(&entry, &WORKING.integer(i64::from(row.squared())));
            }
            SHORT.converted(&entry, WORKING)
        }));
        self.inverse.distance_from_unit(&vector, place) + tail
    }

    /// The parts of Z2 on the ball of this radius: of directions of which one is that of mu, and of
    /// two of the motion.
    fn curvature(&self, slopes: &[Vec<Expr>], radius: Bound) -> Result<[Bound; 2], NotProved> {
        let problem = &self.problem;
        let ball: Vec<FourierSeries> =
            problem.motions.iter().map(|motion| motion.clone().widened(radius)).collect();
        let norm = |force: &Expr| -> Result<Bound, NotProved> {
            Ok(problem.values_along(force, &ball)?.norm())
        };
        let (mut first, mut second) = (Bound::ZERO, Bound::ZERO);
        for (column, name) in problem.coordinates.iter().enumerate() {
            let mut sum = Bound::ZERO;
            for row in slopes {
                sum += norm(&row[column])?;
            }
            first = first.max(sum);
            // Second derivatives are symmetric.
            for other in 0..=column {
                let mut sum = Bound::ZERO;
                for row in slopes {
                    sum += norm(&row[other].differentiate(*name)?)?;
                }
                second = second.max(sum);
            }
        }
        let sigma = self.inverse.sigma.value();
        let mu = WORKING.magnitude(&problem.mu) + radius.over(sigma);
        Ok([self.size * first.over(sigma), self.size * (mu * second)])
    }
}

#[cfg(test)]
mod tests {
    use num_traits::Zero as _;

    use super::*;
    use crate::certificate::{ModeCertificate, certify_mode};
    use crate::exact::ratio;
    use crate::modes::{FreeSystem, ModeOptions, derive};
    use crate::solution::AmplitudeConvention;

    /// The certificate of a mode of some equations.
    fn certificate(
        equations: &str,
        number: usize,
        amplitude: AmplitudeConvention,
        at: &str,
    ) -> ModeCertificate {
        let system = FreeSystem::parse(equations).expect("equations");
        let options = ModeOptions { mode: Some(number), amplitude, ..ModeOptions::default() };
        let modes = derive(&system, &options).expect("modes");
        let mode = modes.modes[0].as_ref().expect("a mode");
        let proved = certify_mode(&modes.system, mode, &at.parse().expect("values"));
        proved.unwrap_or_else(|error| panic!("{equations}: {error}")).0
    }

    /// Odd polynomials and the first harmonic, a force with a tail and all harmonics and the start of
    /// a coordinate, and three coordinates.
    fn certificates() -> Vec<ModeCertificate> {
        use AmplitudeConvention::{FirstHarmonic, Initial};
        let pair = "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0";
        let smooth = "x'' + exp(x) - 1 + x/5 - y = 0; 3*y'' + sin(2*y) + y^2/4 - x/2 = 0";
        let three = "x'' + 2*x - y = 0; y'' + 3*y - x - z + y^3 = 0; z'' + 2*z - y + z^3/3 = 0";
        vec![
            certificate(pair, 1, FirstHarmonic, "a = 4/5"),
            certificate(pair, 2, Initial, "A = 4/5"),
            certificate(smooth, 2, Initial, "A = 1/5"),
            certificate(smooth, 2, FirstHarmonic, "a = 1/5"),
            certificate(three, 3, FirstHarmonic, "a = 1/2"),
        ]
    }

    /// The cosine of a harmonic.
    fn cosine(harmonic: usize) -> FourierSeries {
        let mut balls = vec![Ball::zero(); harmonic];
        balls.push(WORKING.integer(1));
        FourierSeries::exactly(balls, vec![])
    }

    /// DF at a motion, along the direction of mu, `None`, or of a harmonic: of the condition, and of
    /// the equations.
    fn derivative(
        problem: &ConservativeProblem,
        motions: &[FourierSeries],
        mu: &Ball,
        direction: Option<CoordinateHarmonic>,
    ) -> (Ball, Vec<FourierSeries>) {
        let value = |force: &Expr| problem.values_along(force, motions).expect("a value");
        let Some(wave) = direction else {
            return (Ball::zero(), problem.forces.iter().map(|force| value(force)).collect());
        };
        let mu = FourierSeries::constant(mu.clone());
        let own = cosine(wave.harmonic);
        let row = |(index, force): (usize, &&Expr)| {
            let slope = force.differentiate(problem.coordinates[wave.coordinate]).expect("a slope");
            let bent = mu.product(&value(&slope).product(&own));
            match index == wave.coordinate {
                true => bent.sum(&own.derivative().derivative()),
                false => bent,
            }
        };
        let condition = match &problem.condition {
            Condition::Start { coordinate, .. } if *coordinate == wave.coordinate => {
                WORKING.integer(1)
            }
            Condition::FirstHarmonic { factors, .. } if wave.harmonic == 1 => {
                factors[wave.coordinate].clone()
            }
            _ => Ball::zero(),
        };
        (condition, problem.forces.iter().enumerate().map(row).collect())
    }

    /// The norm of B of values of the condition and the equations, less a direction.
    fn size_of_image(
        system: &BoundData,
        (condition, equations): &(Ball, Vec<FourierSeries>),
        less: Option<Option<CoordinateHarmonic>>,
    ) -> f64 {
        let (mut start, mut beyond) = (WORKING.nearest(condition), 0.0);
        for wave in system.beyond(BoundData::longest(equations) + 1) {
            let value = WORKING.nearest(&equations[wave.coordinate].cosine(wave.harmonic));
            let y = -value / f64::from(wave.squared());
            let own = if less == Some(Some(wave)) { 1.0 } else { 0.0 };
            beyond += (y - own).abs();
            if let Condition::Start { coordinate, .. } = &system.problem.condition
                && *coordinate == wave.coordinate
            {
                start -= y;
            }
        }
        let start = crate::exact::rational::from_f64(start).expect("a number");
        let mut vector = vec![WORKING.fraction(&start)];
        let entry = |wave: &CoordinateHarmonic| equations[wave.coordinate].cosine(wave.harmonic);
        vector.extend(system.block.iter().map(entry));
        let mut image = system.inverse.image(&vector, WORKING);
        let place = |direction: Option<CoordinateHarmonic>| match direction {
            None => Some(0),
            Some(wave) => place_of(system, wave),
        };
        if let Some(place) = less.and_then(place) {
            image[place] = WORKING.difference(&image[place], &WORKING.integer(1));
        }
        beyond + system.inverse.norm(&image, WORKING).value()
    }

    fn place_of(system: &BoundData, wave: CoordinateHarmonic) -> Option<usize> {
        system.block.iter().position(|other| *other == wave).map(|place| place + 1)
    }

    /// Every direction up to a harmonic, each with its weight in the norm.
    fn directions(system: &BoundData, highest: usize) -> Vec<(Option<CoordinateHarmonic>, f64)> {
        let waves = system.waves(0, highest).map(|wave| (Some(wave), 1.0));
        std::iter::once((None, system.inverse.sigma.value())).chain(waves).collect()
    }

    #[test]
    fn no_column_is_larger_than_its_bound() {
        for sound in certificates() {
            let mut spoilt = sound.clone();
            for row in &mut spoilt.inverse {
                row[3] = &row[3] * Integer::from(3) / Integer::from(2);
            }
            let mut light = sound.clone();
            light.sigma = -40;
            for (certificate, is_proved) in [(&sound, true), (&spoilt, false), (&light, false)] {
                let system = BoundData::new(certificate.problem()).expect("a system");
                let slopes = Slopes::new(&system.problem).expect("slopes");
                let contraction = system.contraction(&slopes).expect("a bound").value();
                // With half of a column too much, the bound is at least a half.
                assert_eq!(contraction < 0.45, is_proved, "{contraction}");
                let problem = &system.problem;
                for (direction, weight) in directions(&system, 3 * certificate.highest + 90) {
                    let image = derivative(problem, &problem.motions, &problem.mu, direction);
                    let size = size_of_image(&system, &image, Some(direction)) / weight;
                    let bound = match direction {
                        None => system.column_of_mu(),
                        Some(wave) => system.column(&slopes, wave, place_of(&system, wave)),
                    };
                    let bound = bound.value();
                    // The truncated part of f' is in the norm `size`, not in the column.
                    assert!(size <= bound * (1.0 + 1e-9) + 1e-9, "{direction:?}: {size}, {bound}");
                    assert!(size > 0.99 * bound - 1e-9, "{direction:?}: {size}, {bound}");
                    assert!(size <= contraction + 1e-9, "{direction:?}: {size}, {contraction}");
                }
            }
        }
    }

    #[test]
    fn what_a_series_leaves_out_counts() {
        for certificate in certificates() {
            let more = Bound::exactly(0.001);
            let own = BoundData::new(certificate.problem()).expect("a system");
            let (size, mu) = (own.size.value(), WORKING.nearest(&own.problem.mu));
            let last = certificate.coordinates.len() - 1;
            let mut wider = BoundData::new(certificate.problem()).expect("a system");
            wider.forces[last].tail += more;
            let by = wider.defect().value() - own.defect().value();
            assert!((by / (0.001 * size * mu) - 1.0).abs() < 1e-9, "{by}");
            let by = wider.column_of_mu().value() - own.column_of_mu().value();
            let expected = 0.001 * size / own.inverse.sigma.value();
            assert!((by / expected - 1.0).abs() < 1e-9, "{by}");
            let slopes = || Slopes::new(&own.problem).expect("slopes");
            let contraction =
                |slopes: &Slopes| own.contraction(slopes).expect("a contraction").value();
            // Two forces by one coordinate: the column has both.
            let mut wide = slopes();
            for force in [0, last] {
                wide.values[force][last].series.tail += more;
            }
            let by = contraction(&wide) - contraction(&slopes());
            assert!((by / (0.002 * size * mu) - 1.0).abs() < 1e-6, "{by}");
        }
    }

    #[test]
    fn what_is_off_is_in_the_defect() {
        for certificate in certificates() {
            let defect = |certificate: &ModeCertificate| {
                let system = BoundData::new(certificate.problem()).expect("a system");
                system.defect().value() * f64::from(1 << 20)
            };
            assert!(defect(&certificate) < 1e-9);
            let last = certificate.coordinates.len() - 1;
            let unit = Integer::from(1) << (certificate.bits - 20);
            // A harmonic beyond the block, of a coordinate that the condition does not feel.
            let mut shaken = certificate.clone();
            shaken.coefficients[last].resize(42, Integer::zero());
            shaken.coefficients[last][41] += unit.clone();
            assert!((defect(&shaken) - 1.0).abs() < 0.2, "{}", defect(&shaken));
            // One in the block, the frequency and the amplitude: B is nearly the inverse.
            let mut shaken = certificate.clone();
            shaken.coefficients[last][3] += unit.clone();
            assert!((defect(&shaken) - 1.0).abs() < 0.45, "{}", defect(&shaken));
            let mut shaken = certificate.clone();
            shaken.mu += unit;
            let weight = Bound::power_of_two(certificate.sigma).value();
            assert!((defect(&shaken) / weight - 1.0).abs() < 0.45, "{}", defect(&shaken));
            let mut shaken = certificate.clone();
            shaken.amplitude = &shaken.amplitude + ratio(1, 1 << 20);
            let system = BoundData::new(certificate.problem()).expect("a system");
            let expected = system.start.value();
            assert!((defect(&shaken) / expected - 1.0).abs() < 1e-6, "{}", defect(&shaken));
        }
    }

    #[test]
    fn the_second_derivative_is_no_larger_than_its_bound() {
        for certificate in certificates() {
            let (h, within) = (Bound::power_of_two(-20), WORKING.fraction(&ratio(1, 1 << 20)));
            let system = BoundData::new(certificate.problem()).expect("a system");
            let problem = &system.problem;
            let slopes = Slopes::new(problem).expect("slopes");
            let [by_mu, by_motion] =
                system.curvature(&slopes.expressions, h).expect("a bound").map(Bound::value);
            let all = directions(&system, certificate.highest + 6);
            let mut largest = [0.0_f64; 2];
            for (from, weight) in directions(&system, 3) {
                let (mut motions, mut mu) = (problem.motions.clone(), problem.mu.clone());
                // So far that the norm of the step is h.
                match from {
                    None => mu = WORKING.sum(&mu, &within),
                    Some(from) => {
                        let step = FourierSeries::constant(within.clone());
                        let moved = &mut motions[from.coordinate];
                        *moved = moved.sum(&cosine(from.harmonic).product(&step));
                    }
                }
                for (along, other) in &all {
                    let moved = derivative(problem, &motions, &mu, *along);
                    let own = derivative(problem, &problem.motions, &problem.mu, *along);
                    let change =
                        moved.1.iter().zip(&own.1).map(|(moved, own)| moved.difference(own));
                    let change = (Ball::zero(), change.collect());
                    let size = size_of_image(&system, &change, None) / (h.value() * weight * other);
                    let both = [from.is_some(), along.is_some()];
                    let bound = match both {
                        [false, false] => 0.0,
                        [true, true] => by_motion,
                        _ => by_mu,
                    };
                    assert!(
                        size <= bound * (1.0 + 1e-9) + 1e-9,
                        "{from:?}, {along:?}: {size}, {bound}"
                    );
                    if both != [false, false] {
                        let kind = usize::from(both == [true, true]);
                        largest[kind] = largest[kind].max(size);
                    }
                }
            }
            assert!(largest[0] > 0.1 * by_mu && largest[1] > 0.1 * by_motion, "{largest:?}");
        }
    }

    #[test]
    fn a_ball_with_rest_or_half_the_period_is_refused() {
        let certificate = certificates().remove(0);
        let problem = certificate.problem();
        let sigma = Bound::power_of_two(certificate.sigma);
        let first = problem.motions.iter().map(|motion| WORKING.nearest(&motion.cosine(1)).abs());
        let first = first.fold(0.0, f64::max);
        let mu = WORKING.nearest(&problem.mu) * sigma.value();
        let least = first.min(mu);
        assert!(problem.is_distinct(Bound::exactly(0.99 * least), sigma));
        assert!(!problem.is_distinct(Bound::exactly(1.01 * least), sigma));
        assert!(!problem.is_distinct(Bound::exactly(1.01 * first), Bound::exactly(1e9)));
        assert!(problem.is_distinct(Bound::exactly(0.99 * first), Bound::exactly(1e9)));
    }

    #[test]
    fn odd_harmonics_are_refused_where_there_are_others() {
        let mut certificate = certificates().remove(2);
        certificate.odd = true;
        assert_eq!(prove(certificate.problem()), Err(NotProved::NotOdd));
        let mut certificate = certificates().remove(0);
        certificate.odd = true;
        certificate.coefficients[1][2] = Integer::from(1);
        assert_eq!(prove(certificate.problem()), Err(NotProved::NotOdd));
    }
}

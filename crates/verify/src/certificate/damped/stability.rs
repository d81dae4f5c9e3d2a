//! The stability of a motion: enclosures of its Floquet multipliers.
//!
//! Along the proved motion X, every motion within its radius, the variational equation is
//!
//! ```text
//! y'' + p (G(X) y)' + p^2 h'(X) y = 0:      y' = z - G y,  z' = -H y,      G = p g(X),  H = p^2 h'(X)
//! M = the fundamental matrix after theta = 2 pi, of 2 N rows for N coordinates; the multipliers are its eigenvalues
//! ```
//!
//! Of a driven motion of one coordinate two numbers decide:
//!
//! ```text
//! det = exp(-2 pi [G]_0)  (Liouville)       T = trace of M
//! det < 1 and |T| < 1 + det:  both multipliers are inside the unit circle      det > 1 or |T| > 1 + det:  one is outside
//! ```
//!
//! Of several coordinates the largest modulus of the eigenvalues, the spectral radius rho, lies
//! between two numbers for every power m of M, without any eigenvector, so that it does not matter
//! whether M has a basis of them:
//!
//! ```text
//! |trace M^m|/(2 N) <= rho^m <= ||M^m||        m = 1, 2, 4, ..., each by squaring the one before
//! ```
//!
//! The right side is Gelfand's formula; the trace is a sum of 2 N powers. The motion attracts if
//! rho is below one, and is unstable if it is above. What is known of M is lost the sooner the
//! larger its norm beside rho: mostly six digits of rho or more are left, of a matrix that is far
//! from normal or without a basis of eigenvectors some three.
//!
//! A limit cycle has the multiplier one with the eigenvector `w = (X', z)`, and
//! `z = X'' + p g(X) X' = -p^2 h(X)`, at theta = 0. With a unit vector e, `M - w e^T/(e^T w)` has
//! zero in its place and the other eigenvalues of M (Wielandt's deflation): of them rho is taken, and
//! the cycle attracts if it is below one. X' is not known from the radius, which is one of X, but
//! from the equation: with F at the numbers of the certificate, which the bars denote, and the
//! integral of F' and F'' free of a mean,
//!
//! ```text
//! X' = -p phi(X) - p^2 (integral of h(X)) + mean
//! ||X' - Xbar'|| <= ||F|| + p ||g|| r + |p - pbar| ||g(Xbar) Xbar'|| + p^2 ||h'|| r + (p + pbar) |p - pbar| ||h(Xbar)||
//! ```
//!
//! The period is divided into equal steps h, in each of which G and H are polynomials of degree
//! below m, from their Fourier series, and a remainder. The fundamental matrix of a step is a Taylor
//! polynomial P of degree m in `tau = (theta - theta_j)/h`; what it leaves of `P' = h A P` is bounded
//! by the coefficients themselves, and its error by that times `exp(h ||A||)`. With
//! `z` in the unit s, a power of two near `sqrt ||H||`, both halves of A have nearly the same norm.
//! The cost is that of `K (K + N) m + K N^3 m^2` products of short balls for K harmonics.
//!
//! Source: K. Makino, M. Berz: Taylor models and other validated functional inclusion methods, Int.
//! J. Pure Appl. Math. 4 (2003), 379-456; R. Castelli, J.-P. Lessard: Rigorous numerics in Floquet
//! theory, SIAM J. Appl. Dyn. Syst. 12 (2013), 204-245, for a proof of the same by Fourier series;
//! R. A. Horn, C. R. Johnson: Matrix Analysis, Cambridge 2013, section 5.6 (Gelfand's formula) and
//! 1.2 (deflation).

use std::f64::consts::TAU;

use num_traits::Signed as _;

use super::super::CheckError;
use super::super::elementary::Analytic as _;
use super::super::formula::{Enclosure, SizeBounds, hold_both, waves};
use super::super::fourier_series::{FourierSeries, WORKING};
use super::problem::{DampedProblem, SeriesMatrix};
use crate::decimal::neighbours;
use crate::exact::Rational;
use crate::exact::ball::{Ball, Balls};
use crate::exact::bound::Bound;
use crate::exact::rational::from_f64;

/// The precision of the steps: what a period makes of an error, `exp` of the integral of `||A||`, is
/// some 1e10.
const BALLS: Balls = Balls { bits: 120 };

/// The degree of the Taylor polynomials.
const DEGREE: usize = 20;

/// Steps of a period, for each harmonic of the coefficients: `K h` is below 0.4. Of several
/// coordinates there are fewer where the last harmonics are small.
const STEPS_OF_HARMONIC: usize = 16;

/// The largest number of steps of a period.
const MOST_STEPS: usize = 20_000;

/// Largest number of steps of a period times the cube of the number of coordinates.
const MOST_PRODUCTS: f64 = 400_000.0;

/// Binary digits of the coefficients: only stability has to be decided.
const DIGITS: i32 = 90;

/// Enclosed Floquet multipliers of a driven motion, over the period of the certificate.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Multipliers {
    /// Their product.
    pub determinant: Enclosure,
    /// Their sum.
    pub trace: Enclosure,
    /// The larger modulus; `None` where it is not known whether they are real.
    pub largest: Option<Enclosure>,
    /// Whether both are inside the unit circle, `false` if one is outside; `None` if neither is
    /// proved.
    pub attracts: Option<bool>,
}

/// The stability of a motion, as far as it is proved.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Stability {
    /// Whether neighbouring motions approach it: all Floquet multipliers, of a limit cycle all but
    /// the one along the motion, are inside the unit circle; `false` if one is outside, `None` if
    /// neither is proved.
    pub attracts: Option<bool>,
    /// The largest modulus of these multipliers over the period of the certificate, from both sides;
    /// `None` if nothing is known of it.
    pub largest: Option<SizeBounds>,
}

impl Stability {
    /// The stability of which nothing is proved.
    pub(super) const UNKNOWN: Self = Self { attracts: None, largest: None };

    /// The stability of a limit cycle of one coordinate, from its characteristic exponent and
    /// `p = 1/omega`: over a period the multiplier is `exp(2 pi p exponent)`.
    pub(super) fn of_exponent(exponent: &Ball, reciprocal: &Ball) -> Self {
        let turn = WORKING.product(&WORKING.scaled(&WORKING.pi(), 2), reciprocal);
        let multiplier = FourierSeries::constant(WORKING.product(&turn, exponent)).exponential();
        let decided = WORKING.distance_from_zero(exponent) > 0.0;
        Self {
            attracts: decided.then(|| exponent.middle.is_negative()),
            largest: multiplier.map(|value| Enclosure::from_ball(&value.at_zero()).size()),
        }
    }

    /// The stability that follows from the largest modulus.
    fn from_largest(largest: SizeBounds) -> Self {
        let attracts = match (largest.upper < 1.0, largest.lower > 1.0) {
            (true, _) => Some(true),
            (_, true) => Some(false),
            _ => None,
        };
        Self { attracts, largest: Some(largest) }
    }
}

/// The stability that a certificate claims for its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimedStability {
    /// Whether the motion attracts; `None` if nothing is claimed of that.
    pub attracts: Option<bool>,
    /// The largest modulus of the multipliers, from both sides; `None` if nothing is claimed of it.
    pub largest: Option<[Rational; 2]>,
}

impl ClaimedStability {
    /// The claims that follow from a proof.
    pub(in crate::certificate) fn of(stability: &Stability) -> Self {
        /// Decimal digits of the claims: a multiplier may be near one.
        const DIGITS: usize = 9;
        let around = |value: f64| neighbours(&from_f64(value).unwrap_or_default(), DIGITS);
        let ends = |ends: SizeBounds| {
            let ([lower, _], [_, upper]) = (around(ends.lower), around(ends.upper));
            [lower, upper]
        };
        Self { attracts: stability.attracts, largest: stability.largest.map(ends) }
    }

    /// Holds the claims against what is proved.
    ///
    /// # Errors
    /// A claim that is not proved.
    pub(in crate::certificate) fn hold(
        &self,
        proved: Option<&Stability>,
    ) -> Result<(), CheckError> {
        let proved = proved.unwrap_or(&Stability::UNKNOWN);
        if self.attracts.is_some() && self.attracts != proved.attracts {
            return Err(CheckError::Stability);
        }
        match (&self.largest, proved.largest) {
            (None, _) => Ok(()),
            (Some(claim), Some(ends)) => hold_both("the largest Floquet multiplier", ends, claim),
            (Some(_), None) => Err(CheckError::Stability),
        }
    }
}

/// The stability of the motion within this radius of that of a problem of any number of
/// coordinates. Nothing is proved if its coefficients have no value, turn too fast or are too many.
pub(super) fn stability(problem: &DampedProblem, radius: Bound) -> Stability {
    spectral_radius_of(problem, radius).map_or(Stability::UNKNOWN, Stability::from_largest)
}

/// The largest modulus of the multipliers, of a limit cycle without the one along the motion.
fn spectral_radius_of(problem: &DampedProblem, radius: Bound) -> Option<SizeBounds> {
    let [damping, stiffness] = problem.variational(DIGITS, radius)?;
    let mut monodromy = Monodromy::new([&damping, &stiffness])?;
    if problem.is_free() {
        let [velocities, forces] = problem.rates_at_zero(radius)?;
        monodromy.deflate(&velocities, &forces)?;
    }
    spectral_radius(monodromy.matrix)
}

/// The spectral radius of every matrix in this one, from both sides; `None` if nothing is known
/// of it.
fn spectral_radius(mut power: Matrix) -> Option<SizeBounds> {
    /// The number of squarings: the roots of the factors by which the bounds miss are then one.
    const SQUARINGS: usize = 44;
    /// The largest binary exponent of a factor that brings a power near one: less than the digits of
    /// a ball.
    const LARGEST_SHIFT: f64 = 100.0;
    let size = Bound::exactly(power.len() as f64);
    let root = |bound: Bound, times: usize| (0..times).fold(bound, |bound, _| bound.sqrt());
    let one = Bound::exactly(1.0);
    // rho = scale * rho(power)^(1/2^squarings), and what is kept of the scale are bounds of it and
    // of its inverse.
    let (mut scale, mut inverse) = (one, one);
    let mut found: Option<SizeBounds> = None;
    for squarings in 0..=SQUARINGS {
        let upper = (scale * root(norm(&power), squarings)).value();
        let trace = BALLS.distance_from_zero(&trace(&power));
        // The inverse of the lower bound, rounded up.
        let lower = inverse * root(size.over(trace), squarings);
        let lower = (1.0 / lower.value()).next_down().max(0.0);
        let known = found.get_or_insert(SizeBounds { lower, upper });
        *known = SizeBounds { lower: known.lower.max(lower), upper: known.upper.min(upper) };
        let shift = -norm(&power).value().log2().round();
        if shift.is_nan() || shift.abs() > LARGEST_SHIFT {
            break;
        }
        let [factor, back] = [shift, -shift].map(|shift| Bound::power_of_two(shift as i32));
        scale = scale * root(back, squarings);
        inverse = inverse * root(factor, squarings);
        let factor = BALLS.fraction(&from_f64(factor.value())?);
        for entry in power.iter_mut().flatten() {
            *entry = BALLS.product(entry, &factor);
        }
        power = product(&power, &power);
    }
    found.filter(|found| found.upper.is_finite())
}

/// The multipliers of the motion of one coordinate within this radius of that of a problem; `None`
/// if its coefficients have no value, or turn too fast.
pub(super) fn multipliers(problem: &DampedProblem, radius: Bound) -> Option<Multipliers> {
    /// More than 2 pi.
    const TURN: f64 = 6.3;
    let [damping, stiffness] = problem.variational(DIGITS, radius)?;
    let mean = damping.first()?.first()?;
    let mut exponent = WORKING.scaled(&WORKING.product(&WORKING.pi(), &mean.cosine(0)), -2);
    exponent.radius += mean.tail * Bound::exactly(TURN);
    let determinant = FourierSeries::constant(exponent).exponential()?.at_zero();
    let trace = trace(&Monodromy::new([&damping, &stiffness])?.matrix);
    let trace = WORKING.converted(&trace, BALLS);
    Some(Multipliers::from_trace(&trace, &determinant))
}

impl Multipliers {
    /// Two multipliers of this sum and product.
    pub(in crate::certificate) fn from_trace(trace: &Ball, determinant: &Ball) -> Self {
        let edge = WORKING.sum(&WORKING.integer(1), determinant);
        let [least, least_trace, least_edge] =
            [determinant, trace, &edge].map(|ball| WORKING.distance_from_zero(ball));
        let [most, most_trace, most_edge] =
            [determinant, trace, &edge].map(|ball| WORKING.magnitude(ball).value());
        let attracts = match most < 1.0 && most_trace < least_edge {
            true => Some(true),
            false if least > 1.0 || least_trace > most_edge => Some(false),
            false => None,
        };
        Self {
            largest: largest(determinant, trace).map(|ball| Enclosure::from_ball(&ball)),
            determinant: Enclosure::from_ball(determinant),
            trace: Enclosure::from_ball(trace),
            attracts,
        }
    }

    /// Returns the stability that the multipliers prove.
    pub(in crate::certificate) fn stability(&self) -> Stability {
        Stability { attracts: self.attracts, largest: self.largest.as_ref().map(Enclosure::size) }
    }
}

/// The larger modulus of the two numbers of this product and sum; `None` if it is not known whether
/// they are real.
fn largest(product: &Ball, sum: &Ball) -> Option<Ball> {
    let square = WORKING.product(sum, sum);
    let discriminant = WORKING.difference(&square, &WORKING.scaled(product, 4));
    if WORKING.distance_from_zero(&discriminant) <= 0.0 {
        return None;
    }
    match WORKING.root(&discriminant, 2) {
        // Two real numbers: the larger modulus is (|T| + sqrt(T^2 - 4 det))/2.
        Some(root) => {
            let size = WORKING.root(&square, 2)?;
            Some(WORKING.divided(&WORKING.sum(&size, &root), 2))
        }
        None => WORKING.root(product, 2),
    }
}

/// The size of each harmonic in the coefficients, in doubles.
fn sizes_of_harmonics(matrices: [&SeriesMatrix; 2], harmonics: usize, unit: i32) -> Vec<f64> {
    let scales = [1.0, 2.0_f64.powi(-unit)];
    let size = |k: usize| {
        let own = |series: &FourierSeries| {
            let [a, b] = [series.cosine(k), series.sine(k)];
            WORKING.magnitude(&a) + WORKING.magnitude(&b)
        };
        let of_matrix =
            |(matrix, scale): (&SeriesMatrix, f64)| largest_row(matrix, own).value() * scale;
        matrices.into_iter().zip(scales).map(of_matrix).fold(0.0, f64::max)
    };
    (0..harmonics).map(size).collect()
}

/// The number of steps of a turn in which the Taylor polynomials of coefficients with harmonics of
/// these sizes leave out next to nothing, and in which no solution grows too much. A harmonic that
/// is small need not be followed closely.
fn enough_steps(sizes: &[f64], rate: f64) -> f64 {
    /// A bound of what is left out, beside errors of the steps that no number of them makes smaller.
    const NEXT_TO_NOTHING: f64 = 1e-29;
    let left_out = |steps: f64| -> f64 {
        let step = TAU / steps;
        let power = |size: f64, turned: f64| {
            (1..=DEGREE).fold(step * size, |part, n| part * turned * step / n as f64)
        };
        let of_coefficients: f64 =
            sizes.iter().enumerate().map(|(k, size)| power(*size, k as f64)).sum();
        of_coefficients + power(rate, rate)
    };
    // The growth in a step is at most 1/2, with some room for rounding.
    let mut steps = (2.01 * TAU * rate).max(STEPS_OF_HARMONIC as f64);
    while left_out(steps) > NEXT_TO_NOTHING && steps < MOST_STEPS as f64 {
        steps *= 1.1;
    }
    steps
}

/// A coefficient of the variational equation, in short balls.
struct Coefficient {
    cosines: Vec<Ball>,
    sines: Vec<Ball>,
    /// Bound of what its Taylor polynomial of degree below [`DEGREE`] leaves out of a step.
    remainder: Bound,
}

impl Coefficient {
    fn new(series: &FourierSeries, step: Bound) -> Self {
        let short = |ball: Ball| BALLS.converted(&ball, WORKING);
        let cosines: Vec<Ball> = (0..series.length()).map(|k| short(series.cosine(k))).collect();
        let sines: Vec<Ball> = (0..series.length()).map(|k| short(series.sine(k))).collect();
        let mut remainder = series.tail;
        for (k, (a, b)) in cosines.iter().zip(&sines).enumerate() {
            // max |f^(m)| h^m/m! of one harmonic.
            let part = BALLS.magnitude(a) + BALLS.magnitude(b);
            let turned = step * Bound::exactly(k as f64);
            remainder += (1..=DEGREE).fold(part, |part, n| part * turned / n as u32);
        }
        Self { cosines, sines, remainder }
    }

    /// Whether the odd harmonics are zero.
    fn has_even_alone(&self) -> bool {
        let odd = |balls: &[Ball]| balls.iter().skip(1).step_by(2).all(Ball::is_zero);
        odd(&self.cosines) && odd(&self.sines)
    }

    /// The coefficients of its Taylor polynomial in `tau` about the place of a step, from the cosine
    /// and the sine of the multiples of the angle there, and `(k h)^n/n!`.
    fn polynomial(&self, place: usize, table: &[[Ball; 2]], powers: &[Vec<Ball>]) -> Vec<Ball> {
        let mut polynomial = vec![Ball::zero(); DEGREE];
        for (k, (a, b)) in self.cosines.iter().zip(&self.sines).enumerate() {
            if a.is_zero() && b.is_zero() {
                continue;
            }
            let [cosine, sine] = &table[k * place % table.len()];
            // f = u, f' = k v, f'' = -k^2 u, f''' = -k^3 v.
            let u = BALLS.sum(&BALLS.product(a, cosine), &BALLS.product(b, sine));
            let v = BALLS.difference(&BALLS.product(b, cosine), &BALLS.product(a, sine));
            for (n, entry) in polynomial.iter_mut().enumerate() {
                let part = BALLS.product(if n % 2 == 0 { &u } else { &v }, &powers[k][n]);
                *entry = match n % 4 {
                    0 | 1 => BALLS.sum(entry, &part),
                    _ => BALLS.difference(entry, &part),
                };
                if k == 0 {
                    break;
                }
            }
        }
        polynomial
    }
}

/// A square matrix, row by row.
type Matrix = Vec<Vec<Ball>>;

fn product(left: &Matrix, right: &Matrix) -> Matrix {
    let entry = |row: &[Ball], column: usize| {
        row.iter().zip(right).fold(Ball::zero(), |sum, (own, other)| {
            BALLS.sum(&sum, &BALLS.product(own, &other[column]))
        })
    };
    let columns = right.first().map_or(0, Vec::len);
    left.iter().map(|row| (0..columns).map(|column| entry(row, column)).collect()).collect()
}

/// Adds a matrix to another.
fn add(sum: &mut Matrix, part: &Matrix) {
    for (entry, own) in sum.iter_mut().flatten().zip(part.iter().flatten()) {
        *entry = BALLS.sum(entry, own);
    }
}

fn zero_matrix(size: usize) -> Matrix {
    vec![vec![Ball::zero(); size]; size]
}

fn unit_matrix(size: usize) -> Matrix {
    let mut unit = zero_matrix(size);
    for (place, row) in unit.iter_mut().enumerate() {
        row[place] = BALLS.integer(1);
    }
    unit
}

/// The largest sum of a row.
fn norm(matrix: &Matrix) -> Bound {
    largest_row(matrix, |entry| BALLS.magnitude(entry))
}

/// The largest sum of a bound over a row of a matrix.
fn largest_row<Entry>(matrix: &[Vec<Entry>], bound: impl Fn(&Entry) -> Bound) -> Bound {
    matrix.iter().map(|row| row.iter().map(&bound).sum()).fold(Bound::ZERO, Bound::max)
}

fn trace(matrix: &Matrix) -> Ball {
    let diagonal = matrix.iter().enumerate().map(|(place, row)| &row[place]);
    diagonal.fold(Ball::zero(), |sum, entry| BALLS.sum(&sum, entry))
}

/// The fundamental matrix of `y' = z - G y`, `z' = -H y` after a turn, with z in units of a power
/// of two.
struct Monodromy {
    matrix: Matrix,
    /// The inverse of the unit of z.
    lighter: Ball,
}

impl Monodromy {
    /// The fundamental matrix; `None` if the coefficients turn too fast, or are too many.
    fn new([damping, stiffness]: [&SeriesMatrix; 2]) -> Option<Self> {
        let count = damping.len();
        let [damping, stiffness] = [damping, stiffness].map(|matrix| -> SeriesMatrix {
            let short = |series: &FourierSeries| series.clone().shortened(DIGITS);
            matrix.iter().map(|row| row.iter().map(short).collect()).collect()
        });
        // z is counted in units of 2^unit, so that both halves have about the same norm.
        let stiff = largest_row(&stiffness, FourierSeries::norm);
        let unit = (0.5 * stiff.value().log2()).round().clamp(-40.0, 40.0);
        let unit = if unit.is_finite() { unit as i32 } else { 0 };
        let scale = Bound::power_of_two(unit);
        let drag = largest_row(&damping, FourierSeries::norm);
        let rate = (scale + drag).max(stiff * Bound::power_of_two(-unit));
        let lengths = damping.iter().chain(&stiffness).flatten().map(FourierSeries::length);
        let harmonics = lengths.max().unwrap_or(0).max(1);
        let fastest = (harmonics as f64).max(rate.value()).ceil();
        let mut steps = fastest * STEPS_OF_HARMONIC as f64;
        if count > 1 {
            // Each of them costs the cube of the number of coordinates.
            let sizes = sizes_of_harmonics([&damping, &stiffness], harmonics, unit);
            steps = steps.min(enough_steps(&sizes, rate.value()));
        }
        let fits = steps <= MOST_STEPS as f64 && steps * (count as f64).powi(3) <= MOST_PRODUCTS;
        if !fits {
            return None;
        }
        let half = (steps.ceil() as usize).div_ceil(2);
        let table = waves(half, BALLS);
        let step = BALLS.divided(&BALLS.pi(), u32::try_from(half).ok()?);
        let width = BALLS.magnitude(&step);
        let growth = width * rate;
        // exp(1/2) is below 2.
        if growth > Bound::exactly(0.5) {
            return None;
        }
        let powers: Vec<Vec<Ball>> = (0..harmonics)
            .map(|k| {
                let turned = BALLS.scaled(&step, k as i64);
                let next = |power: &Ball, n: usize| {
                    BALLS.divided(&BALLS.product(power, &turned), n as u32)
                };
                let mut list = vec![BALLS.integer(1)];
                for n in 1..DEGREE {
                    list.push(next(&list[n - 1], n));
                }
                list
            })
            .collect();
        let [damping, stiffness] = [&damping, &stiffness].map(|matrix| -> Vec<Vec<Coefficient>> {
            let row = |row: &Vec<FourierSeries>| {
                row.iter().map(|series| Coefficient::new(series, width)).collect()
            };
            matrix.iter().map(row).collect()
        });
        let unit_ball = BALLS.fraction(&from_f64(scale.value())?);
        let lighter = BALLS.fraction(&from_f64(1.0 / scale.value())?);
        let [of_drag, of_force] = [&damping, &stiffness]
            .map(|matrix| largest_row(matrix, |coefficient| coefficient.remainder));
        let remainder = width * of_drag.max(of_force * Bound::power_of_two(-unit));
        let mut all = unit_matrix(2 * count);
        // With even harmonics alone both halves of the period have the same enclosure, also of the
        // part that is in no harmonic.
        let repeats = damping.iter().chain(&stiffness).flatten().all(Coefficient::has_even_alone);
        for place in 0..if repeats { half } else { 2 * half } {
            // h A, by powers of tau.
            let mut rates = vec![zero_matrix(2 * count); DEGREE];
            let scaled = |ball: &Ball| BALLS.product(&step, ball);
            for i in 0..count {
                rates[0][i][count + i] = scaled(&unit_ball);
                for j in 0..count {
                    let [g, h] = [&damping, &stiffness]
                        .map(|matrix| matrix[i][j].polynomial(place, &table, &powers));
                    for (rate, (g, h)) in rates.iter_mut().zip(g.iter().zip(&h)) {
                        rate[i][j] = scaled(&BALLS.scaled(g, -1));
                        let back = BALLS.scaled(&BALLS.product(&lighter, h), -1);
                        rate[count + i][j] = scaled(&back);
                    }
                }
            }
            all = product(&step_matrix(&rates, remainder), &all);
        }
        if repeats {
            all = product(&all, &all);
        }
        Some(Self { matrix: all, lighter })
    }

    /// Puts zero in the place of the eigenvalue one of a limit cycle, whose eigenvector is made of
    /// the velocities and, with the other sign, of the forces; `None` if all of these may be zero.
    fn deflate(&mut self, velocities: &[Ball], forces: &[Ball]) -> Option<()> {
        let short = |ball: &Ball| BALLS.converted(ball, WORKING);
        let forces = forces.iter().map(short);
        let forces = forces.map(|force| BALLS.scaled(&BALLS.product(&self.lighter, &force), -1));
        let vector: Vec<Ball> = velocities.iter().map(short).chain(forces).collect();
        let size = |place: &usize| BALLS.distance_from_zero(&vector[*place]);
        let largest = (0..vector.len()).max_by(|one, other| size(one).total_cmp(&size(other)))?;
        for (row, own) in self.matrix.iter_mut().zip(&vector) {
            let part = BALLS.quotient(own, &vector[largest])?;
            row[largest] = BALLS.difference(&row[largest], &part);
        }
        Some(())
    }
}

/// The fundamental matrix of a step `Y' = (sum_n A_n tau^n + R) Y` from `tau = 0` to 1, where
/// `||A|| <= 1/2` and R has this bound.
fn step_matrix(rates: &[Matrix], remainder: Bound) -> Matrix {
    let size = rates.first().map_or(0, Vec::len);
    let mut terms = vec![unit_matrix(size)];
    for n in 0..DEGREE {
        let mut sum = zero_matrix(size);
        for (rate, term) in rates.iter().zip(terms.iter().rev()) {
            add(&mut sum, &product(rate, term));
        }
        for entry in sum.iter_mut().flatten() {
            *entry = BALLS.divided(entry, n as u32 + 1);
        }
        terms.push(sum);
    }
    let sizes: Vec<Bound> = terms.iter().map(norm).collect();
    // P' - A P: the products of the polynomials beyond the degree of P', and R P.
    let mut left = remainder * sizes.iter().copied().sum::<Bound>();
    for (j, rate) in rates.iter().enumerate() {
        let size = norm(rate);
        left += size * sizes[DEGREE - j..].iter().copied().sum::<Bound>();
    }
    let error = left * Bound::exactly(2.0);
    let mut sum = zero_matrix(size);
    for term in &terms {
        add(&mut sum, term);
    }
    for entry in sum.iter_mut().flatten() {
        entry.radius += error;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::super::candidate::units;
    use super::super::candidate::proved_by_some_block;
    use super::*;
    use crate::certificate::{certify_driven, check_damped};
    use crate::exact::rational::to_f64;
    use crate::expr::CompiledFunction;
    use crate::{Options, Oscillator, solve};

    /// A constant and a cosine of twice the angle, and what is in neither.
    fn series(constant: f64, cosine: f64) -> FourierSeries {
        let ball = |value: f64| WORKING.fraction(&from_f64(value).expect("a number"));
        FourierSeries::exactly(vec![ball(constant), Ball::zero(), ball(cosine)], vec![])
    }

    /// The trace of the fundamental matrix of one coordinate.
    fn trace_of(damping: FourierSeries, stiffness: FourierSeries) -> Ball {
        let [damping, stiffness] = [damping, stiffness].map(|series| vec![vec![series]]);
        let found = Monodromy::new([&damping, &stiffness]).expect("a matrix");
        WORKING.converted(&trace(&found.matrix), BALLS)
    }

    #[test]
    fn constant_coefficients_have_a_closed_trace() {
        // y'' + G y' + H y = 0: T = 2 exp(-pi G) cos(2 pi w), w^2 = H - G^2/4, or cosh.
        for (g, h) in [(0.0, 1.3), (0.1, 2.0), (0.5, 0.04), (-0.2, 9.5), (0.3, -0.2), (0.0, 0.0)] {
            let square: f64 = h - g * g / 4.0;
            let turn = std::f64::consts::TAU * square.abs().sqrt();
            let wave = if square > 0.0 { turn.cos() } else { turn.cosh() };
            let expected = 2.0 * (-std::f64::consts::PI * g).exp() * wave;
            let found = trace_of(series(g, 0.0), series(h, 0.0));
            assert!((WORKING.nearest(&found) - expected).abs() < 1e-11 * expected.abs().max(1.0));
            assert!(found.radius.value() < 1e-12, "{g}, {h}: {:?}", found.radius);
        }
    }

    /// The trace after a turn of the angle, by Runge-Kutta of fourth order.
    fn followed(damping: &dyn Fn(f64) -> f64, stiffness: &dyn Fn(f64) -> f64) -> f64 {
        const STEPS: usize = 20_000;
        let h = std::f64::consts::TAU / STEPS as f64;
        let end = |mut state: [f64; 2]| {
            for step in 0..STEPS {
                let theta = h * step as f64;
                let field = |at: f64, [y, z]: [f64; 2]| [z - damping(at) * y, -stiffness(at) * y];
                let moved = |rate: [f64; 2], part: f64| {
                    [state[0] + part * h * rate[0], state[1] + part * h * rate[1]]
                };
                let a = field(theta, state);
                let b = field(theta + h / 2.0, moved(a, 0.5));
                let c = field(theta + h / 2.0, moved(b, 0.5));
                let d = field(theta + h, moved(c, 1.0));
                state = [0, 1].map(|i| state[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
            }
            state
        };
        end([1.0, 0.0])[0] + end([0.0, 1.0])[1]
    }

    #[test]
    fn the_trace_of_mathieu_s_equation_is_that_of_runge_kutta() {
        for (g, h, wave) in [(0.0, 1.0, 0.4), (0.1, 1.2, 2.0), (0.05, 4.0, -3.0)] {
            let expected = followed(&|theta| g + wave / 10.0 * (2.0 * theta).cos(), &|theta| {
                h + wave * (2.0 * theta).cos()
            });
            let found = trace_of(series(g, wave / 10.0), series(h, wave));
            let apart = (WORKING.nearest(&found) - expected).abs();
            assert!(apart < 1e-10 * expected.abs().max(1.0), "{apart}");
            assert!(found.radius.value() < 1e-12);
            // All coefficients within a distance: those at its ends have other traces.
            let wide = Bound::exactly(1e-3);
            let found = trace_of(series(g, wave / 10.0), series(h, wave).widened(wide));
            for end in [-1e-3, 1e-3] {
                let other = followed(&|theta| g + wave / 10.0 * (2.0 * theta).cos(), &|theta| {
                    h + end + wave * (2.0 * theta).cos()
                });
                let apart = (WORKING.nearest(&found) - other).abs();
                assert!(apart <= found.radius.value() && apart > 1e-5, "{apart}, {found:?}");
            }
        }
    }

    #[test]
    fn what_a_taylor_polynomial_leaves_out_counts() {
        // exp(1/4) of a constant rate, to all digits, and a remainder as large as it may be.
        let quarter = BALLS.fraction(&crate::exact::ratio(1, 4));
        let diagonal = vec![vec![quarter.clone(), Ball::zero()], vec![Ball::zero(), quarter]];
        let rest = vec![zero_matrix(2); DEGREE - 1];
        let rates: Vec<Matrix> = [diagonal].into_iter().chain(rest).collect();
        let exactly = step_matrix(&rates, Bound::ZERO);
        assert!((BALLS.nearest(&exactly[0][0]) - 0.25_f64.exp()).abs() < 1e-15);
        // The first power that is left out, and not much more than it.
        let left = (1..=21).fold(1.0, |term, n| term / 4.0 / f64::from(n));
        assert!(exactly[0][0].radius.value() > left, "{exactly:?}");
        assert!(exactly[0][0].radius.value() < 100.0 * left + 1e-33, "{exactly:?}");
        let wide = step_matrix(&rates, Bound::exactly(1e-3));
        let off = 0.251_f64.exp() - 0.25_f64.exp();
        assert!(wide[1][1].radius.value() > off && wide[1][1].radius.value() < 4.0 * off);
        // A harmonic of a coefficient: its derivative of the degree of the polynomial.
        let step = 0.05;
        let coefficient = Coefficient::new(&series(0.0, 1.0), Bound::exactly(step));
        let left = (1..=DEGREE).fold(1.0, |term, n| term * 2.0 * step / n as f64);
        assert!((coefficient.remainder.value() / left - 1.0).abs() < 1e-9);
        let tail = Bound::exactly(0.5);
        let wide = Coefficient::new(&series(0.0, 1.0).widened(tail), Bound::exactly(step));
        assert!(wide.remainder.value() > 0.5);
    }

    #[test]
    fn multipliers_of_driven_motions_are_those_of_the_variational_equation() {
        let equation = "x'' + x'/5 + x + x^3/4 - F*cos(Omega*t) = 0";
        let oscillator = Oscillator::parse(equation).expect("an equation");
        let solution = solve(&oscillator, &Options::default()).expect("a solution");
        for (at, frequency) in [("F = 1/2, Omega = 3/2", 1.5), ("F = 1/10, Omega = 1", 1.0)] {
            let at = at.parse().expect("values");
            let (certificate, certified) =
                certify_driven(&oscillator, &solution, &at).expect("a certificate");
            assert_eq!(check_damped(&certificate).as_ref(), Ok(&certified));
            let found = certified.multipliers.expect("multipliers");
            assert_eq!(found.attracts, Some(true));
            let problem = certificate.problem();
            let motion = [0, 1].map(|kind| -> Vec<f64> {
                let parts = 0..problem.motions[0].length();
                parts
                    .map(|k| {
                        let wave = [problem.motions[0].cosine(k), problem.motions[0].sine(k)];
                        WORKING.nearest(&wave[kind])
                    })
                    .collect()
            });
            let x = |theta: f64| -> f64 {
                let waves = motion[0].iter().zip(&motion[1]).enumerate();
                let wave = |(k, (a, b)): (usize, (&f64, &f64))| {
                    a * (k as f64 * theta).cos() + b * (k as f64 * theta).sin()
                };
                waves.map(wave).sum()
            };
            let p = 1.0 / frequency;
            let slope = crate::expr::parse_expression("1 + 3*x^2/4").expect("a slope");
            let slope = CompiledFunction::new(&slope, &["x".into()]).expect("a function");
            let expected = followed(&|_| 0.2 * p, &|theta| p * p * slope.call(&[x(theta)]));
            assert!((to_f64(&found.trace.middle) - expected).abs() < 1e-10, "{found:?}");
            assert!(found.trace.radius.value() < 1e-12, "{found:?}");
            let determinant = (-std::f64::consts::TAU * 0.2 * p).exp();
            assert!((to_f64(&found.determinant.middle) - determinant).abs() < 1e-14);
            // The multipliers are complex there: both have the root of the determinant.
            let largest = to_f64(&found.largest.expect("complex ones").middle);
            assert!((largest - determinant.sqrt()).abs() < 1e-14, "{largest}");
        }
    }

    /// The motion of `x'' + x'/5 + x + x^3/4 = cos(8 t/5)` near the harmonic of an amplitude whose
    /// square is that of a balance with one harmonic.
    fn of_square(square: f64) -> Multipliers {
        let equation = "x'' + x'/5 + x + x^3/4 - F*cos(Omega*t) = 0";
        let oscillator = Oscillator::parse(equation).expect("an equation");
        let solution = solve(&oscillator, &Options::default()).expect("a solution");
        let at = "F = 1, Omega = 8/5".parse().expect("values");
        let found = certify_driven(&oscillator, &solution, &at);
        let (mut certificate, _) = found.expect("a certificate");
        certificate.formula = None;
        let stiffness = 1.0 - 2.56 + 3.0 * square / 16.0;
        let waves = [square * stiffness, square * 0.32];
        let in_units =
            |value: f64| vec![units(0.0, certificate.bits), units(value, certificate.bits)];
        [certificate.cosines, certificate.sines] = waves.map(in_units);
        // Each attempt takes a step of Newton's iteration with an inverse of its own.
        let mut attempts = (0..20).map(|_| proved_by_some_block(&mut certificate, 20).ok());
        let certified = attempts.find_map(|proved| proved).expect("a proof");
        let motion = certificate.motion();
        let [a, b] = [motion.cosine(1), motion.sine(1)].map(|ball| WORKING.nearest(&ball));
        assert!(((a * a + b * b) / square - 1.0).abs() < 0.25, "{a}, {b}, {square}");
        certified.multipliers.expect("multipliers")
    }

    #[test]
    fn of_three_steady_motions_the_middle_one_is_unstable() {
        // u ((3 u/16 - 1.56)^2 + 0.1024) = 1 for the square u of the amplitude: three roots.
        let balance = |u: f64| u * ((3.0 * u / 16.0 - 1.56).powi(2) + 0.1024) - 1.0;
        let mut roots = vec![];
        for place in 1..1200 {
            let [low, high] = [f64::from(place) * 0.01, f64::from(place + 1) * 0.01];
            if (balance(low) < 0.0) != (balance(high) < 0.0) {
                roots.push((low + high) / 2.0);
            }
        }
        assert_eq!(roots.len(), 3, "{roots:?}");
        let [low, middle, high] = [0, 1, 2].map(|place| of_square(roots[place]));
        let determinant = (-std::f64::consts::TAU / 8.0).exp();
        for (found, attracts) in [(&low, true), (&middle, false), (&high, true)] {
            assert_eq!(found.attracts, Some(attracts), "{found:?}");
            assert!((to_f64(&found.determinant.middle) - determinant).abs() < 1e-13);
            assert!(found.trace.radius.value() < 1e-10, "{found:?}");
        }
        let trace = to_f64(&middle.trace.middle);
        assert!(trace > 1.0 + determinant, "{trace}");
        let largest = to_f64(&middle.largest.expect("real ones").middle);
        assert!((largest * (trace - largest) - determinant).abs() < 1e-12 && largest > 1.0);
    }

    #[test]
    fn what_is_not_decided_is_not_said() {
        // A motion that is known too roughly, and one without damping, whose multipliers are on the
        // circle.
        let equation = "x'' + x'/5 + x + x^3/4 - F*cos(Omega*t) = 0";
        let oscillator = Oscillator::parse(equation).expect("an equation");
        let solution = solve(&oscillator, &Options::default()).expect("a solution");
        let at = "F = 1/2, Omega = 3/2".parse().expect("values");
        let (certificate, _) = certify_driven(&oscillator, &solution, &at).expect("a certificate");
        let rough = multipliers(&certificate.problem(), Bound::exactly(0.2));
        assert!(rough.is_none_or(|rough| rough.attracts.is_none()));
        let mut undamped = certificate;
        undamped.damping = crate::expr::Expr::zero();
        let found = multipliers(&undamped.problem(), Bound::ZERO).expect("multipliers");
        assert_eq!(found.attracts, None, "{found:?}");
    }

    /// Fractions row by row, each as its numerator and its denominator.
    type Fractions = &'static [&'static [(i64, i64)]];

    /// A matrix of fractions.
    fn of_fractions(rows: Fractions) -> Matrix {
        let entry =
            |(top, bottom): &(i64, i64)| BALLS.fraction(&crate::exact::ratio(*top, *bottom));
        rows.iter().map(|row| row.iter().map(entry).collect()).collect()
    }

    /// Whether the ends hold a number, and are as near to it as this.
    fn hold(ends: SizeBounds, number: f64, near: f64) -> bool {
        let rounding = number * 4.0 * f64::EPSILON;
        ends.lower <= number + rounding
            && number <= ends.upper + rounding
            && ends.upper - ends.lower <= near
    }

    #[test]
    fn the_spectral_radius_is_that_of_eigenvalues_in_closed_form() {
        // Distinct eigenvalues; a rotation by an angle of which no power is the identity; one of
        // the modulus one; two of opposite sign, whose odd traces cancel; a defective matrix; and one
        // far from normal.
        let cases: [(Fractions, f64); 7] = [
            (&[&[(1, 2), (7, 1)], &[(0, 1), (-3, 4)]], 0.75),
            (&[&[(3, 5), (-1, 2)], &[(1, 2), (3, 5)]], (0.36_f64 + 0.25).sqrt()),
            (&[&[(3, 5), (-4, 5)], &[(4, 5), (3, 5)]], 1.0),
            (&[&[(0, 1), (2, 1)], &[(1, 8), (0, 1)]], 0.5),
            (
                &[
                    &[(9, 10), (1, 1), (0, 1)],
                    &[(0, 1), (9, 10), (1, 1)],
                    &[(0, 1), (0, 1), (9, 10)],
                ],
                0.9,
            ),
            (&[&[(101, 100), (1, 1)], &[(0, 1), (101, 100)]], 1.01),
            (&[&[(0, 1), (1000, 1)], &[(1, 1_000_000_000), (1, 1000)]], {
                let [sum, product] = [1e-3_f64, -1e-6];
                (sum + (sum * sum - 4.0 * product).sqrt()) / 2.0
            }),
        ];
        for (rows, expected) in cases {
            let found = spectral_radius(of_fractions(rows)).expect("two ends");
            assert!(hold(found, expected, 1e-8 * expected), "{rows:?}: {found:?}, {expected}");
        }
        // Every power from the second on vanishes.
        let nilpotent = spectral_radius(of_fractions(&[&[(0, 1), (5, 1)], &[(0, 1), (0, 1)]]));
        assert!(nilpotent.is_some_and(|ends| ends.lower == 0.0 && ends.upper <= 5.0));
        // A circle about the unit circle of which the entries are not known.
        let mut wide = of_fractions(&[&[(99, 100), (0, 1)], &[(0, 1), (1, 2)]]);
        wide[0][0].radius = Bound::exactly(0.02);
        let found = spectral_radius(wide.clone()).expect("two ends");
        assert!(found.lower < 0.98 && found.upper > 1.009, "{found:?}");
        assert_eq!(Stability::from_largest(found).attracts, None);
        wide[1][0].radius = Bound::UNKNOWN;
        assert_eq!(spectral_radius(wide), None);
    }

    /// A limit cycle of van der Pol's equation at this mu.
    fn cycle(mu: &str) -> super::super::DampedCertificate {
        let oscillator = Oscillator::parse("x'' - mu*(1 - x^2)*x' + x + x^2/9 = 0");
        let oscillator = oscillator.expect("an equation");
        let solution = solve(&oscillator, &Options::default()).expect("a solution");
        let at = format!("mu = {mu}").parse().expect("values");
        crate::certificate::certify_cycle_motion(&oscillator, &solution, &at)
            .expect("a certificate")
            .0
    }

    #[test]
    fn without_the_multiplier_along_a_cycle_there_is_that_of_liouville() {
        for mu in ["1/10", "1/2", "1"] {
            let certificate = cycle(mu);
            let proved = check_damped(&certificate).expect("a proof");
            let liouville = proved.stability.expect("a stability");
            assert_eq!(liouville.attracts, Some(true));
            let by_powers = stability(&certificate.problem(), proved.proof.radius);
            assert_eq!(by_powers.attracts, Some(true), "{mu}: {by_powers:?}");
            let [own, other] = [&liouville, &by_powers].map(|own| own.largest.expect("two ends"));
            assert!(own.lower <= other.upper && other.lower <= own.upper, "{own:?}, {other:?}");
            // The matrix without the multiplier one is far from normal where the other is small.
            assert!(other.upper - other.lower < 0.01 * own.upper, "{mu}: {own:?}, {other:?}");
            assert!(own.upper - own.lower < 1e-15);
        }
    }

    #[test]
    fn velocities_of_a_cycle_are_within_their_bounds_of_all_motions_nearby() {
        let certificate = cycle("1");
        let exact = certificate.problem().rates_at_zero(Bound::ZERO).expect("values");
        for harmonic in [1, 2, 5, 9, 16] {
            for is_sine in [false, true] {
                let mut moved = certificate.clone();
                let list = if is_sine { &mut moved.sines } else { &mut moved.cosines };
                list[harmonic] += crate::exact::Integer::from(1) << (moved.bits - 20);
                // The motion is within this distance of the moved one.
                let apart = Bound::power_of_two(-20);
                let found = moved.problem().rates_at_zero(apart).expect("values");
                let mut least = f64::INFINITY;
                for (found, exact) in found.iter().flatten().zip(exact.iter().flatten()) {
                    let apart = WORKING.difference(found, exact);
                    let distance = WORKING.size_of_middle(&apart);
                    assert!(distance <= found.radius, "{harmonic}: {distance:?}, {found:?}");
                    least = least.min(found.radius.value());
                }
                assert!(least < 1e-3, "{least}");
            }
        }
        let mut moved = certificate.clone();
        moved.reciprocal += crate::exact::Integer::from(1) << (moved.bits - 20);
        let apart = Bound::power_of_two(moved.sigma - 20);
        let found = moved.problem().rates_at_zero(apart).expect("values");
        for (found, exact) in found.iter().flatten().zip(exact.iter().flatten()) {
            let apart = WORKING.difference(found, exact);
            assert!(WORKING.size_of_middle(&apart) <= found.radius);
        }
    }

    #[test]
    fn of_one_driven_coordinate_both_ways_agree() {
        let equation = "x'' + x'/5 + x + x^3/4 - F*cos(Omega*t) = 0";
        let oscillator = Oscillator::parse(equation).expect("an equation");
        let solution = solve(&oscillator, &Options::default()).expect("a solution");
        for at in ["F = 1/2, Omega = 3/2", "F = 1/10, Omega = 1"] {
            let at = at.parse().expect("values");
            let (certificate, proved) =
                certify_driven(&oscillator, &solution, &at).expect("a certificate");
            let by_trace = proved.stability.expect("a stability").largest.expect("two ends");
            let by_powers = stability(&certificate.problem(), proved.proof.radius);
            let by_powers = by_powers.largest.expect("two ends");
            assert!(
                hold(by_powers, 0.5 * (by_trace.lower + by_trace.upper), 1e-9),
                "{by_powers:?}"
            );
        }
    }
}

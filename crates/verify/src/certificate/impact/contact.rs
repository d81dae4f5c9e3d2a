//! Enclosures of the greatest depth and of the duration of an elastic contact.
//!
//! Between the touch with the speed v and the deepest point the energy is kept. With the depth d =
//! q^2 every function is analytic:
//!
//! ```text
//! (d')^2 = G(q) = v^2 - 2 (cos xc - cos(xc + q^2)) - (4/p) gamma q^p,     G(qm) = 0,     p = 2 n + 2
//! G(q) = (qm - q) H(q),     y = (qm^2 - q^2)/2,   m = xc + (qm^2 + q^2)/2
//! H(q) = 2 (qm + q) sin(m) sin(y)/y + (4/p) gamma (qm^(p-1) + qm^(p-2) q + ... + q^(p-1))
//! T = 8 sqrt(qm) int_0^1 q/sqrt(H(q)) dw,     q = qm (1 - w^2)
//! ```
//!
//! The force of the barrier is `gamma d^n`; that of Hertz has n = 3/2, p = 5. Until xc + q^2 = pi/2 the slope of G changes its sign at most once, from plus to minus: then qm
//! is the only root, and two signs enclose it. The integral is taken piece by piece by the Taylor
//! series of the integrand about the middle; the remainder is at most the next coefficient enclosed
//! over the whole piece (Corliss and Rall).
//!
//! In: the position of the barrier, its stiffness, the speed. Out: depth and duration as balls. A
//! piece costs three products of series.
//!
//! Source: G. F. Corliss, L. B. Rall: Adaptive, self-validating numerical quadrature, SIAM J. Sci.
//! Stat. Comput. 8 (1987), 831-847.

use num_traits::Signed as _;

use super::NotEnclosed;
use crate::certificate::fourier_series::WORKING;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::{Integer, Rational};

/// Powers of a Taylor series that are kept.
const ORDER: usize = 64;

/// Binary exponent of the largest remainder of the Taylor series on a piece of the integral; a
/// piece with a larger one is halved.
const NEGLIGIBLE: i32 = -140;

/// The contact of the pendulum with a barrier whose force is a power of the depth.
pub(super) struct PowerLawContact {
    /// Place of the barrier.
    pub(super) barrier: Ball,
    /// gamma.
    pub(super) stiffness: Ball,
    /// p, two more than twice the exponent of the depth.
    pub(super) power: u32,
    /// The square of the speed at the touch.
    pub(super) speed_squared: Ball,
    /// Sine and cosine of the place.
    pub(super) waves: [Ball; 2],
}

pub(super) fn product(left: &Ball, right: &Ball) -> Ball {
    WORKING.product(left, right)
}

pub(super) fn sum(left: &Ball, right: &Ball) -> Ball {
    WORKING.sum(left, right)
}

/// Sine and cosine; `None` if the angle is too large.
pub(super) fn sine_and_cosine(angle: &Ball) -> Option<[Ball; 2]> {
    let (series, largest) = ([angle.clone()], WORKING.magnitude(angle));
    let first = |p| even_function(&series, p, largest)?.into_iter().next();
    Some([product(angle, &first(1)?), first(0)?])
}

impl PowerLawContact {
    /// `(4/p) gamma`.
    fn elasticity(&self) -> Ball {
        WORKING.divided(&WORKING.scaled(&self.stiffness, 4), self.power)
    }

    /// `G`, the square of the velocity at the depth `q^2`.
    fn velocity_squared(&self, q: &Ball) -> Option<Ball> {
        let depth = product(q, q);
        let [_, cosine] = sine_and_cosine(&sum(&self.barrier, &depth))?;
        let swing = WORKING.scaled(&WORKING.difference(&self.waves[1], &cosine), 2);
        let elastic = product(&self.elasticity(), &power_of(q, self.power));
        Some(WORKING.difference(&WORKING.difference(&self.speed_squared, &swing), &elastic))
    }

    /// The root `qm` by Newton's method, without a proof.
    fn candidate(&self) -> Option<Ball> {
        const STEPS: usize = 200;
        let degree = f64::from(self.power);
        let power =
            0.25 * degree * WORKING.nearest(&self.speed_squared) / WORKING.nearest(&self.stiffness);
        let start = crate::exact::rational::from_f64(power.powf(1.0 / degree))?;
        let mut q = without_radius(WORKING.fraction(&start));
        for _ in 0..STEPS {
            let depth = product(&q, &q);
            let [sine, _] = sine_and_cosine(&sum(&self.barrier, &depth))?;
            let force = product(&self.stiffness, &power_of(&q, self.power - 2));
            let slope = WORKING.scaled(&product(&q, &sum(&sine, &force)), -4);
            let step = WORKING.quotient(&self.velocity_squared(&q)?, &without_radius(slope))?;
            q = without_radius(WORKING.difference(&q, &step));
            if WORKING.magnitude(&without_radius(step)) <= Bound::power_of_two(-180) {
                return Some(q);
            }
        }
        None
    }

    /// `qm`, the square root of the greatest depth.
    ///
    /// # Errors
    /// [`NotEnclosed::Digits`] if no two signs enclose the root, [`NotEnclosed::Deep`] if it lies
    /// beyond `pi/2`.
    pub(super) fn root_of_depth(&self) -> Result<Ball, NotEnclosed> {
        let mut q = self.candidate().ok_or(NotEnclosed::Digits)?;
        q.radius = Bound::power_of_two(-170);
        let end = |sign: i64| {
            let away = WORKING.dyadic(&Integer::from(sign), 170);
            self.velocity_squared(&sum(&without_radius(q.clone()), &away))
        };
        let (inside, outside) = (end(-1), end(1));
        let proved = inside.is_some_and(|inside| is_positive(&inside))
            && outside.is_some_and(|outside| is_positive(&WORKING.scaled(&outside, -1)));
        if !proved {
            return Err(NotEnclosed::Digits);
        }
        let end = sum(&self.barrier, &product(&q, &q));
        let quarter = WORKING.divided(&WORKING.pi(), 2);
        match is_positive(&WORKING.difference(&quarter, &end)) && is_positive(&q) {
            true => Ok(q),
            false => Err(NotEnclosed::Deep),
        }
    }

    /// The duration of the whole contact.
    ///
    /// # Errors
    /// [`NotEnclosed`] if the integral needs more pieces than the limit.
    pub(super) fn duration(&self, qm: &Ball) -> Result<Ball, NotEnclosed> {
        const FIRST: u32 = 5;
        const SMALLEST: u32 = 12;
        // Middles and halves of the pieces, in units of 2^-halvings.
        let mut pieces: Vec<(u32, u64)> =
            (0..1 << (FIRST - 1)).map(|piece| (FIRST, 2 * piece + 1)).collect();
        let mut integral = Ball::zero();
        while let Some((halvings, middle)) = pieces.pop() {
            match self.piece(qm, halvings, middle) {
                Some(part) => integral = sum(&integral, &part),
                None if halvings < SMALLEST => {
                    pieces.extend([(halvings + 1, 2 * middle - 1), (halvings + 1, 2 * middle + 1)]);
                }
                None => return Err(NotEnclosed::Digits),
            }
        }
        let root = WORKING.root(qm, 2).ok_or(NotEnclosed::Digits)?;
        Ok(WORKING.scaled(&product(&root, &integral), 8))
    }

    /// The integral over `middle +- 1` in units of `2^-halvings`; `None` if the remainder of its
    /// series is too large.
    fn piece(&self, qm: &Ball, halvings: u32, middle: u64) -> Option<Ball> {
        let half = WORKING.dyadic(&Integer::from(1), halvings as usize);
        let centre = WORKING.scaled(&half, i64::try_from(middle).ok()?);
        let whole = Ball { radius: WORKING.magnitude(&half), ..centre.clone() };
        // int_{-1}^1 c_k u^k du is 2 c_k/(k + 1), or nothing.
        let last = self.integrand(qm, &whole, &half)?.pop()?;
        let left = WORKING.magnitude(&WORKING.scaled(&last, 2));
        if left > Bound::power_of_two(NEGLIGIBLE) {
            return None;
        }
        let mut integral = Ball::zero();
        for (k, coefficient) in
            (0..).zip(self.integrand(qm, &centre, &half)?.iter().take(ORDER)).step_by(2)
        {
            integral = sum(&integral, &WORKING.divided(&WORKING.scaled(coefficient, 2), k + 1));
        }
        integral.radius += left;
        Some(product(&integral, &half))
    }

    /// The Taylor coefficients of `q/sqrt(H(q))` at `w + half*u` in u, one more than [`ORDER`].
    fn integrand(&self, qm: &Ball, w: &Ball, half: &Ball) -> Option<Vec<Ball>> {
        let one = WORKING.integer(1);
        let shape = [
            WORKING.difference(&one, &product(w, w)),
            WORKING.scaled(&product(w, half), -2),
            WORKING.scaled(&product(half, half), -1),
        ];
        let q: Vec<Ball> = shape.iter().map(|coefficient| product(qm, coefficient)).collect();
        let (square, deepest) = (multiplied(&q, &q), product(qm, qm));
        let half = |series: Vec<Ball>| -> Vec<Ball> {
            series.iter().map(|ball| WORKING.divided(ball, 2)).collect()
        };
        let negative = square.iter().map(|ball| WORKING.scaled(ball, -1)).collect();
        let y = half(shifted(negative, &deepest));
        let mean = half(shifted(square, &deepest));
        // For |u| <= 1, complex too, it is |w| <= 2 and |q| <= 5 qm.
        let largest = WORKING.magnitude(&deepest) * Bound::exactly(13.0);
        let [sinc_y, sinc_mean, cosine_mean] = [
            even_function(&y, 1, largest)?,
            even_function(&mean, 1, largest)?,
            even_function(&mean, 0, largest)?,
        ];
        let of_sine = scaled(&multiplied(&sinc_mean, &mean), &self.waves[1]);
        let sine = added(scaled(&cosine_mean, &self.waves[0]), &of_sine);
        let both = scaled(&shifted(q.clone(), qm), &WORKING.integer(2));
        let swing = multiplied(&multiplied(&sine, &both), &sinc_y);
        // By Horner's rule, for p = 5: q^4 + qm q^3 + ... = (((q + qm) q + qm^2) q + qm^3) q + qm^4.
        let mut powers = vec![one];
        let mut power = qm.clone();
        for _ in 1..self.power {
            powers = shifted(multiplied(&powers, &q), &power);
            power = product(&power, qm);
        }
        let elastic = scaled(&powers, &self.elasticity());
        let slope = added(swing, &elastic);
        Some(multiplied(&inverse_root(&slope)?, &q))
    }
}

/// A whole power of a number.
fn power_of(number: &Ball, exponent: u32) -> Ball {
    (0..exponent).fold(WORKING.integer(1), |power, _| product(&power, number))
}

/// The middle without the radius, for a mere guess.
fn without_radius(ball: Ball) -> Ball {
    Ball { radius: Bound::ZERO, ..ball }
}

/// Whether every number of the ball is positive.
pub(super) fn is_positive(ball: &Ball) -> bool {
    ball.middle.is_positive() && WORKING.distance_from_zero(ball) > 0.0
}

/// A series with a number added.
fn shifted(mut series: Vec<Ball>, number: &Ball) -> Vec<Ball> {
    if let Some(first) = series.first_mut() {
        *first = sum(first, number);
    }
    series
}

fn scaled(series: &[Ball], factor: &Ball) -> Vec<Ball> {
    series.iter().map(|ball| product(ball, factor)).collect()
}

/// The sum, as long as the longer of the two.
fn added(left: Vec<Ball>, right: &[Ball]) -> Vec<Ball> {
    let count = left.len().max(right.len());
    let zero = Ball::zero();
    let term = |series: &[Ball], k: usize| series.get(k).unwrap_or(&zero).clone();
    (0..count).map(|k| sum(&term(&left, k), &term(right, k))).collect()
}

/// The product up to the power [`ORDER`].
fn multiplied(left: &[Ball], right: &[Ball]) -> Vec<Ball> {
    let count = (left.len() + right.len()).saturating_sub(1).min(ORDER + 1);
    let mut terms = vec![Ball::zero(); count];
    for (i, left) in left.iter().enumerate() {
        for (j, right) in right.iter().enumerate().take(count.saturating_sub(i)) {
            terms[i + j] = sum(&terms[i + j], &product(left, right));
        }
    }
    terms
}

/// `sum_k (-1)^k y^(2 k)/(2 k + p)!`: the cosine for p = 0, `sin(y)/y` for p = 1. In the circle of
/// radius 1 about zero `|y|` is at most `largest`, so that, by Cauchy's estimate, no coefficient of
/// the truncated part exceeds the size of that part there.
fn even_function(y: &[Ball], p: u32, largest: Bound) -> Option<Vec<Ball>> {
    const MOST: u32 = 200;
    let square = multiplied(y, y);
    let size = largest * largest;
    // From here on the ratio of terms is below 1/2: the truncated part is less than twice its first
    // term.
    let (mut count, mut term) = (0, Bound::exactly(1.0));
    while !(term <= Bound::power_of_two(-215)
        && size <= Bound::exactly(f64::from(2 * count * count)))
    {
        count += 1;
        term = term * size / ((2 * count + p) * (2 * count + p - 1));
        if count > MOST {
            return None;
        }
    }
    let one = WORKING.integer(1);
    let mut series = vec![one.clone()];
    for k in (1..count).rev() {
        let factor = (2 * k + p) * (2 * k + p - 1);
        let next = multiplied(&series, &square);
        let next = next.iter().map(|ball| WORKING.scaled(&WORKING.divided(ball, factor), -1));
        series = shifted(next.collect(), &one);
    }
    series.resize(ORDER + 1, Ball::zero());
    let left_out = term + term;
    series.iter_mut().for_each(|ball| ball.radius += left_out);
    Some(series)
}

/// The power -1/2 of a series; `None` if its first coefficient may not be positive.
fn inverse_root(series: &[Ball]) -> Option<Vec<Ball>> {
    let first = series.first()?;
    let mut terms = vec![WORKING.quotient(&WORKING.integer(1), &WORKING.root(first, 2)?)?];
    for n in 1..=ORDER {
        let mut total = Ball::zero();
        for k in 1..=n.min(series.len() - 1) {
            let factor = i64::try_from(k).ok()? - 2 * i64::try_from(n).ok()?;
            total = sum(&total, &WORKING.scaled(&product(&series[k], &terms[n - k]), factor));
        }
        let total = WORKING.divided(&total, u32::try_from(2 * n).ok()?);
        terms.push(WORKING.quotient(&total, first)?);
    }
    Some(terms)
}

/// The place of a barrier and its waves.
pub(super) fn position_and_waves(barrier: &Rational) -> Option<(Ball, [Ball; 2])> {
    let place = WORKING.fraction(barrier);
    let waves = sine_and_cosine(&place)?;
    Some((place, waves))
}

#[cfg(test)]
mod tests {
    use num_traits::Signed as _;

    use super::{ORDER, even_function, inverse_root, multiplied, sine_and_cosine};
    use crate::certificate::fourier_series::WORKING;
    use crate::exact::ball::Ball;
    use crate::exact::bound::Bound;
    use crate::exact::rational::{Rational, from_f64, to_f64};

    fn ball(above: i64, below: i64) -> Ball {
        WORKING.fraction(&Rational::new(above.into(), below.into()))
    }

    fn holds(ball: &Ball, number: &Rational) -> bool {
        let radius = from_f64(ball.radius.value()).expect("a finite radius");
        (WORKING.middle(ball) - number).abs() <= radius
    }

    #[test]
    fn waves_of_an_angle_are_on_the_circle_and_where_doubles_say() {
        for (above, below) in [(1, 3), (-5, 2), (22, 7), (0, 1), (-1, 1000)] {
            let [sine, cosine] = sine_and_cosine(&ball(above, below)).expect("waves");
            let squares = [&sine, &cosine].map(|wave| WORKING.product(wave, wave));
            let sum = WORKING.sum(&squares[0], &squares[1]);
            assert!(holds(&sum, &Rational::from_integer(1.into())) && sum.radius.value() < 1e-60);
            let angle = above as f64 / below as f64;
            assert!((WORKING.nearest(&sine) - angle.sin()).abs() < 1e-15);
            assert!((WORKING.nearest(&cosine) - angle.cos()).abs() < 1e-15);
        }
    }

    /// The root of a series, squared and multiplied by it, is one; a wide first coefficient has the
    /// roots of all its numbers.
    #[test]
    fn the_inverse_root_of_a_series_undoes_it() {
        let series = [ball(9, 4), ball(1, 3), ball(-1, 5), ball(2, 7)];
        let root = inverse_root(&series).expect("a root");
        let one = multiplied(&multiplied(&root, &root), &series);
        assert_eq!(one.len(), ORDER + 1);
        for (k, coefficient) in one.iter().enumerate() {
            assert!(holds(coefficient, &Rational::from_integer(i64::from(k == 0).into())), "{k}");
        }
        let wide = Ball { radius: Bound::exactly(0.25), ..ball(9, 4) };
        let root = inverse_root(&[wide.clone(), ball(1, 3)]).expect("a root");
        for number in [2.0_f64, 2.25, 2.5] {
            // The coefficients of (c + u/3)^(-1/2).
            let exact = [number.powf(-0.5), -number.powf(-1.5) / 6.0, number.powf(-2.5) / 24.0];
            for (ball, exact) in root.iter().zip(exact) {
                assert!(
                    (to_f64(&WORKING.middle(ball)) - exact).abs() <= ball.radius.value() + 1e-15
                );
            }
        }
        assert!(inverse_root(&[Ball { radius: Bound::exactly(3.0), ..wide }]).is_none());
    }

    /// The radii include the remainder of the series of a function: with fewer terms they are
    /// wider, and all of them contain the function.
    #[test]
    fn a_function_of_a_series_holds_what_was_left_out() {
        let y = [ball(1, 3), ball(1, 2)];
        // |1/3 + u/2| <= 1 for |u| <= 1, and 4 bounds it as well.
        for largest in [1.0, 4.0] {
            let cosine = even_function(&y, 0, Bound::exactly(largest)).expect("a series");
            let exact =
                [(1.0_f64 / 3.0).cos(), -(1.0_f64 / 3.0).sin() / 2.0, -(1.0_f64 / 3.0).cos() / 8.0];
            for (ball, exact) in cosine.iter().zip(exact) {
                assert!((WORKING.nearest(ball) - exact).abs() < 1e-15);
            }
            let last = cosine.last().expect("coefficients");
            assert!(last.radius > Bound::ZERO && last.radius.value() < 1e-60);
        }
        assert!(even_function(&y, 0, Bound::exactly(1e4)).is_none());
    }
}

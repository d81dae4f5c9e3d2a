//! Elementary functions in an algebra of functions that are known up to a distance: of an angle, or of two.
//!
//! In: the operations of the algebra, in which the norm of a product is at most the product of the norms. Out: an
//! enclosure of the function of all its arguments. It is a Taylor series of an argument that has been halved until
//! it is small, or the result of Newton's iteration, whose residual is enclosed.
//!
//! Source: J.-P. Lessard, J. D. Mireles James: Computer assisted Fourier analysis in sequence
//! spaces of varying regularity, SIAM Journal on Mathematical Analysis 49 (2017), 530-561.

use num_traits::Signed as _;

use super::fourier_series::WORKING;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;

/// The largest number of halvings of an argument; the function of a series of larger norm is
/// refused.
const MOST_HALVINGS: u32 = 6;

/// Steps of Newton's iteration, each of which doubles the digits: from those of a double to more
/// than are kept.
const STEPS: usize = 3;

/// The largest number of terms of a Taylor series.
const MOST_TERMS: u32 = 28;

/// Functions that are known up to a distance, of which sums, products and functions are such functions too.
pub(super) trait Analytic: Clone + Sized {
    /// A constant.
    fn constant(value: Ball) -> Self;

    /// `self + other`.
    fn sum(&self, other: &Self) -> Self;

    /// `self - other`.
    fn difference(&self, other: &Self) -> Self;

    /// `self * other`.
    fn product(&self, other: &Self) -> Self;

    /// `self * factor`.
    fn scaled(&self, factor: i64) -> Self;

    /// `self / divisor`, for a divisor that is not zero.
    fn divided(&self, divisor: u32) -> Self;

    /// The norm.
    fn norm(&self) -> Bound;

    /// The set of all functions within a distance of those in this one.
    fn widened(self, distance: Bound) -> Self;

    /// An enclosure of the value where all angles are zero, and so of a constant function.
    fn at_zero(&self) -> Ball;

    /// The binary exponent below which the size of a coefficient is negligible, with its sign changed.
    fn negligible(&self) -> i32;

    /// The middles without radii, which suffice for the guess of an iteration.
    fn without_radii(self) -> Self;

    /// Approximates `function` of this one from samples, without a proof. `None` if a sample has no value.
    fn sampled(&self, function: impl Fn(f64) -> f64) -> Option<Self>;

    /// A whole number.
    fn integer(value: i64) -> Self {
        Self::constant(WORKING.integer(value))
    }

    /// `-self`.
    fn negated(&self) -> Self {
        self.scaled(-1)
    }

    /// `self * self`.
    fn squared(&self) -> Self {
        self.product(self)
    }

    /// `self / divisor`; `None` if zero may be among the divisors.
    fn over(&self, divisor: &Ball) -> Option<Self> {
        let inverse = WORKING.quotient(&WORKING.integer(1), divisor)?;
        Some(self.product(&Self::constant(inverse)))
    }

    /// A whole power.
    fn power(&self, exponent: u32) -> Self {
        let mut result: Option<Self> = None;
        let mut square = self.clone();
        let mut rest = exponent;
        while rest > 0 {
            if rest % 2 == 1 {
                result =
                    Some(result.map_or_else(|| square.clone(), |result| result.product(&square)));
            }
            rest /= 2;
            if rest > 0 {
                square = square.squared();
            }
        }
        result.unwrap_or_else(|| Self::integer(1))
    }

    /// This function divided by a power of two so that its norm is at most a half, and the number
    /// of halvings; `None` if that is too large.
    fn scaled_to_half_norm(&self) -> Option<(Self, u32)> {
        let norm = self.norm();
        let halvings = (0..=MOST_HALVINGS)
            .find(|&halvings| norm <= Bound::power_of_two(halvings as i32 - 1))?;
        Some((self.divided(1 << halvings), halvings))
    }

    /// Sine and cosine; `None` if the norm is too large.
    fn sine_and_cosine(&self) -> Option<(Self, Self)> {
        let (argument, halvings) = self.scaled_to_half_norm()?;
        let minus_square = argument.squared().negated();
        let terms = self.terms();
        // Both series have the powers of the square: the terms of that of the cosine, each divided
        // by an odd number, are those of the sine over the argument.
        let mut term = Self::integer(1);
        let (mut sine, mut cosine) = (term.clone(), term.clone());
        for k in 1..=terms / 2 {
            term = term.product(&minus_square).divided(2 * k * (2 * k - 1));
            cosine = cosine.sum(&term);
            sine = sine.sum(&term.divided(2 * k + 1));
        }
        let mut sine = argument.product(&sine).widened(remainder(terms + 3));
        let mut cosine = cosine.widened(remainder(terms + 2));
        for _ in 0..halvings {
            let doubled = sine.product(&cosine).scaled(2);
            cosine = Self::integer(1).difference(&sine.squared().scaled(2));
            sine = doubled;
        }
        Some((sine, cosine))
    }

    /// The exponential function; `None` if the norm is too large.
    fn exponential(&self) -> Option<Self> {
        let (argument, halvings) = self.scaled_to_half_norm()?;
        let terms = self.terms();
        let mut sum = Self::integer(1);
        for k in (1..=terms).rev() {
            sum = Self::integer(1).sum(&argument.product(&sum).divided(k));
        }
        sum = sum.widened(remainder(terms + 1));
        for _ in 0..halvings {
            sum = sum.squared();
        }
        Some(sum)
    }

    /// `self^(-1/degree)`, positive; `None` if that is not proved to exist.
    ///
    /// With any `g` that is positive at the angle 0 and `w = 1 - u g^n`, `d = ||w|| < 1`:
    /// `u^(-1/n) = g (1 - w)^(-1/n)`, which is within `||g|| d^2/(1 - d)` of `g (1 + w/n)`, for no
    /// coefficient of the binomial series is larger than one.
    fn inverse_root(&self, degree: u32) -> Option<Self> {
        let mut root = self.sampled(|u| u.powf(-1.0 / f64::from(degree)))?;
        let next = |root: &Self, defect: &Self| root.sum(&root.product(defect).divided(degree));
        let mut defect = self.defect(&root, degree);
        for _ in 0..STEPS {
            if defect.norm() < enough(self.negligible()) {
                break;
            }
            root = next(&root, &defect).without_radii();
            defect = self.defect(&root, degree);
        }
        let distance = defect.norm();
        let left = distance.below_complement();
        let spread = root.norm() * (distance * distance).over(left);
        let proved = left > 0.0 && root.start().is_some_and(|start| start > 0.0);
        proved.then(|| next(&root, &defect).widened(spread))
    }

    /// `1 - self g^n`.
    fn defect(&self, root: &Self, degree: u32) -> Self {
        Self::integer(1).difference(&self.product(&root.power(degree)))
    }

    /// `1/self`; `None` if that is not proved to exist.
    fn inverse(&self) -> Option<Self> {
        match self.start()? < 0.0 {
            true => Some(self.negated().inverse_root(1)?.negated()),
            false => self.inverse_root(1),
        }
    }

    /// The natural logarithm; `None` if that is not proved to exist.
    ///
    /// With any `g` and `w = u exp(-g)`, `d = ||w - 1|| < 1`: `log u = g + log w`, and `log w` is
    /// within `d^2/(2 (1 - d))` of `w - 1`.
    fn logarithm(&self) -> Option<Self> {
        let mut guess = self.sampled(f64::ln)?;
        let beyond = |guess: &Self| {
            Some(self.product(&guess.negated().exponential()?).difference(&Self::integer(1)))
        };
        let mut rest = beyond(&guess)?;
        for _ in 0..STEPS {
            if rest.norm() < enough(self.negligible()) {
                break;
            }
            guess = guess.sum(&rest).without_radii();
            rest = beyond(&guess)?;
        }
        let distance = rest.norm();
        let left = distance.below_complement();
        (left > 0.0).then(|| guess.sum(&rest).widened((distance * distance).over(left)))
    }

    /// The arctangent; `None` if that is not proved.
    ///
    /// With any `g` and `w = (u cos g - sin g)/(cos g + u sin g)`, which is `tan(atan u - g)`, and
    /// `||w|| = d < 1/32`: the continuous function `atan u - g` stays within `d` of one multiple of
    /// pi. That is zero if `|g| < pi/2 - d` at the angle 0, and then it is `atan w`, within `d^3`
    /// of `w`.
    fn arctangent(&self) -> Option<Self> {
        let mut guess = self.sampled(f64::atan)?;
        let mut rest = self.angle_beyond(&guess)?;
        for _ in 0..STEPS {
            if rest.norm() < enough(self.negligible()) {
                break;
            }
            guess = guess.sum(&rest).without_radii();
            rest = self.angle_beyond(&guess)?;
        }
        let distance = rest.norm();
        // 1.57 is below pi/2.
        let principal = WORKING.magnitude(&guess.at_zero()) + distance < Bound::exactly(1.57);
        (principal && distance < Bound::exactly(1.0 / 32.0))
            .then(|| guess.sum(&rest).widened(distance * distance * distance))
    }

    /// `tan(atan self - guess)`.
    fn angle_beyond(&self, guess: &Self) -> Option<Self> {
        let (sine, cosine) = guess.sine_and_cosine()?;
        let above = self.product(&cosine).difference(&sine);
        Some(above.product(&cosine.sum(&self.product(&sine)).inverse()?))
    }

    /// A double between zero and its value at the angle 0, of the same sign; `None` if zero may be
    /// that value.
    fn start(&self) -> Option<f64> {
        let value = self.at_zero();
        let distance = WORKING.distance_from_zero(&value);
        (distance > 0.0).then(|| if value.middle.is_negative() { -distance } else { distance })
    }

    /// The number of terms of a Taylor series after which the remainder is negligible, for an
    /// argument of norm at most 1/2; an even number.
    fn terms(&self) -> u32 {
        let negligible = Bound::power_of_two(-self.negligible() - 8);
        let mut left = Bound::exactly(2.0);
        for k in 1..MOST_TERMS {
            left = left / (2 * k);
            if k % 2 == 1 && k >= 3 && left < negligible {
                return k - 1;
            }
        }
        MOST_TERMS
    }
}

/// The residual at which an initial guess is good enough: its square is negligible.
fn enough(negligible: i32) -> Bound {
    Bound::power_of_two(-negligible / 2)
}

/// Bound of the remainder of the Taylor series of sine, cosine or exponential from the power n on,
/// for an argument of norm at most 1/2: `sum_(k >= n) 2^-k/k! <= 2 * 2^-n/n!`.
fn remainder(from: u32) -> Bound {
    (1..=from).fold(Bound::exactly(2.0), |bound, k| bound / (2 * k))
}

//! Sums of products of balls, such as the coefficients of a product of Fourier series.
//!
//! In: balls, each prepared once as a factor of many products. Out: the sums, each rounded once. The
//! middles are words of whole lists, so that no product and no sum has memory of its own: a product
//! of middles of n words costs n^2 products of words and the additions to the sums that it is in.

use num_traits::Signed as _;

use super::ball::{Ball, Balls, radius_of_product};
use super::bound::Bound;
use super::integer::Integer;

/// A ball as a factor of many products.
#[derive(Clone, Debug)]
pub struct BallFactor {
    /// Whether the middle is negative.
    negative: bool,
    /// The absolute value of the middle, its lowest word first.
    words: Vec<u64>,
    radius: Bound,
    /// A bound of the absolute value of the middle.
    size: Bound,
}

impl BallFactor {
    /// Prepares a ball.
    pub fn new(balls: Balls, ball: &Ball) -> Self {
        Self {
            negative: ball.middle.is_negative(),
            words: ball.middle.to_words(),
            radius: ball.radius,
            size: balls.size_of_middle(ball),
        }
    }

    /// Returns an upper bound of the absolute values of all numbers in the ball.
    pub fn magnitude(&self) -> Bound {
        self.size + self.radius
    }
}

/// Sums of products of balls, not rounded yet.
#[derive(Clone, Debug)]
pub struct BallProductSums {
    /// Number of words of each sum.
    width: usize,
    /// The sums in two's complement, one after the other, the lowest word of each first.
    words: Vec<u64>,
    radii: Vec<Bound>,
    /// The latest product.
    product: Vec<u64>,
}

impl BallProductSums {
    /// So many sums, all zero, of products of these factors.
    pub fn new<'a>(count: usize, factors: impl Iterator<Item = &'a BallFactor>) -> Self {
        let longest = factors.map(|factor| factor.words.len()).max().unwrap_or(0);
        // One word more has room for the sign, and for as many products as there can be.
        let width = 2 * longest + 1;
        Self {
            width,
            words: vec![0; count * width],
            radii: vec![Bound::ZERO; count],
            product: vec![0; width],
        }
    }

    /// Adds a product to each of some sums, or subtracts it where `true` is beside the index of the
    /// sum.
    pub fn add(
        &mut self,
        left: &BallFactor,
        right: &BallFactor,
        sums: impl IntoIterator<Item = (usize, bool)>,
    ) {
        let product = &mut self.product[..left.words.len() + right.words.len()];
        multiply(&left.words, &right.words, product);
        let radius = radius_of_product([left.radius, right.radius], [left.size, right.size]);
        for (sum, negative) in sums {
            let words = &mut self.words[sum * self.width..][..self.width];
            match negative != (left.negative != right.negative) {
                true => accumulate(words, product, u64::overflowing_sub),
                false => accumulate(words, product, u64::overflowing_add),
            }
            self.radii[sum] += radius;
        }
    }

    /// The sums, each halved so many times and rounded to a ball with the digits of the factors on one side;
    /// those on the other side have `places` binary digits after the point.
    pub fn rounded(mut self, balls: Balls, places: usize, halvings: u32) -> Vec<Ball> {
        let sums = self.words.chunks_exact_mut(self.width).zip(self.radii);
        let places = places + halvings as usize;
        let rounded = |(words, radius): (&mut [u64], Bound)| {
            let radius = match halvings {
                0 => radius,
                _ => radius * Bound::power_of_two(-(halvings as i32)),
            };
            balls.shifted(&signed(words), places, radius)
        };
        sums.map(rounded).collect()
    }
}

/// The product of two numbers that are not negative, in as many words as both have together.
fn multiply(left: &[u64], right: &[u64], product: &mut [u64]) {
    product.fill(0);
    for (place, own) in left.iter().enumerate() {
        let (words, above) = product[place..].split_at_mut(right.len());
        let mut carry = 0;
        for (word, other) in words.iter_mut().zip(right) {
            // The largest value is 2^128 - 1.
            let sum = u128::from(*own)
                .wrapping_mul(u128::from(*other))
                .wrapping_add(u128::from(*word))
                .wrapping_add(u128::from(carry));
            (*word, carry) = (sum as u64, (sum >> 64) as u64);
        }
        above[0] = carry;
    }
}

/// Adds a number that is not negative to one in two's complement, or subtracts it, word by word.
#[inline(always)]
fn accumulate(words: &mut [u64], number: &[u64], operation: impl Fn(u64, u64) -> (u64, bool)) {
    let (low, high) = words.split_at_mut(number.len());
    let mut carry = false;
    for (word, own) in low.iter_mut().zip(number) {
        let (once, first) = operation(*word, *own);
        let (twice, second) = operation(once, carry.into());
        (*word, carry) = (twice, first | second);
    }
    for word in high {
        if !carry {
            break;
        }
        (*word, carry) = operation(*word, 1);
    }
}

/// The integer in two's complement; the words are not of use any more.
fn signed(words: &mut [u64]) -> Integer {
    let negative = words.last().is_some_and(|word| word >> 63 == 1);
    if !negative {
        return Integer::from_words(words);
    }
    let mut carry = true;
    for word in words.iter_mut() {
        (*word, carry) = (!*word).overflowing_add(carry.into());
    }
    -Integer::from_words(words)
}

#[cfg(test)]
mod tests {
    use num_traits::Zero as _;
    use proptest::prelude::*;

    use super::*;

    const BALLS: Balls = Balls { bits: 100 };

    /// Middles of none to six words and of both signs, with and without radii.
    fn ball() -> impl Strategy<Value = Ball> {
        let word = prop_oneof![Just(0), Just(u64::MAX), any::<u64>()];
        let radius = prop_oneof![Just(0.0), 0.0..3.0_f64];
        (prop::collection::vec(word, 0..7), any::<bool>(), radius).prop_map(
            |(mut words, negative, radius)| {
                let size = Integer::from_words(&mut words);
                let middle = if negative { -size } else { size };
                Ball { middle, radius: Bound::exactly(radius) }
            },
        )
    }

    proptest! {
        #[test]
        fn sums_are_those_of_integers(pairs in prop::collection::vec((ball(), ball(), any::<bool>()), 0..20)) {
            let factors: Vec<[BallFactor; 2]> =
                pairs.iter().map(|(left, right, _)| [left, right].map(|ball| BallFactor::new(BALLS, ball))).collect();
            let mut sums = BallProductSums::new(2, factors.iter().flatten());
            let (mut units, mut radius) = (Integer::zero(), Bound::ZERO);
            for ((left, right, negative), [own, other]) in pairs.iter().zip(&factors) {
                // The other sum has every product with the other sign.
                sums.add(own, other, [(0, *negative), (1, !*negative)]);
                let product = &left.middle * &right.middle;
                units += if *negative { -product } else { product };
                radius += BALLS.radius_of_product(left, right);
            }
            let expected = [units.clone(), -units].map(|units| BALLS.rounded(&units, radius));
            prop_assert_eq!(sums.rounded(BALLS, BALLS.bits, 0), expected);
        }
    }
}

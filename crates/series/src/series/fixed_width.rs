//! Short Fourier series: numerators of two machine words over one denominator, without symbols and
//! without heap memory for each number.
//!
//! The size of a result is bounded beforehand from the largest numerators of the arguments. If the
//! bound exceeds two words, the operation returns `None`: no result is ever wrong, and no addition
//! or multiplication has to check for overflow.

use super::waves::Wave;

/// Bound of numerators and of all intermediate sums. It is half of what fits, which leaves room for
/// rounding errors in the estimates of the sizes.
const BOUND: f64 = (1_u128 << 126) as f64;

/// Bound of the numbers that fit one word, whose product is a single instruction; with the same
/// room.
const WORD: f64 = (1_u64 << 62) as f64;

/// Zeros to be overwritten, once; few of them need no heap memory.
struct Zeros {
    few: [i128; Self::FEW],
    many: Vec<i128>,
}

impl Zeros {
    const FEW: usize = 64;

    fn new() -> Self {
        Self { few: [0; Self::FEW], many: vec![] }
    }

    /// So many of them.
    fn take(&mut self, count: usize) -> &mut [i128] {
        match self.few.get_mut(..count) {
            Some(few) => few,
            None => {
                self.many.resize(count, 0);
                &mut self.many
            }
        }
    }
}

/// A fraction in lowest terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShortFraction {
    numerator: i128,
    denominator: i128,
}

impl ShortFraction {
    /// The number zero.
    pub const ZERO: Self = Self { numerator: 0, denominator: 1 };
    /// The number one.
    pub const ONE: Self = Self { numerator: 1, denominator: 1 };

    /// The fraction with this numerator and this positive denominator, which need not be in lowest
    /// terms; `None` if they are too long.
    pub fn new(numerator: i128, denominator: i128) -> Option<Self> {
        if denominator <= 0 || size(numerator.unsigned_abs()) >= BOUND {
            return None;
        }
        let common = greatest_common_divisor(denominator, numerator);
        let [numerator, denominator] =
            [numerator, denominator].map(|number| exact_quotient(number, common));
        Some(Self { numerator, denominator })
    }

    /// The numerator.
    pub fn numerator(self) -> i128 {
        self.numerator
    }

    /// The denominator, positive.
    pub fn denominator(self) -> i128 {
        self.denominator
    }

    /// Whether it is zero.
    pub fn is_zero(self) -> bool {
        self.numerator == 0
    }

    /// The negative number.
    pub fn negative(self) -> Self {
        Self { numerator: -self.numerator, ..self }
    }

    /// The least common denominator of some fractions, and their numerators over it; `None` if a
    /// number is too long.
    pub fn over_common_denominator(fractions: &[Self]) -> Option<(i128, Vec<i128>)> {
        let lengthened =
            |common, fraction: &Self| least_common_multiple(common, fraction.denominator);
        let common = fractions.iter().try_fold(1, lengthened)?;
        let numerators = fractions.iter().map(|fraction| {
            product(fraction.numerator, exact_quotient(common, fraction.denominator))
        });
        Some((common, numerators.collect::<Option<_>>()?))
    }

    /// Half of the number; `None` if it is too long.
    pub fn half(self) -> Option<Self> {
        // The other part is odd or keeps its factors of two, so the result is in lowest terms.
        match self.numerator & 1 {
            0 => Some(Self { numerator: self.numerator >> 1, ..self }),
            _ => Some(Self { denominator: product(self.denominator, 2)?, ..self }),
        }
    }

    /// The product; `None` if it is too long.
    pub fn product(self, other: Self) -> Option<Self> {
        let numerator = product(self.numerator, other.numerator)?;
        Self::new(numerator, product(self.denominator, other.denominator)?)
    }

    /// The quotient; `None` if it is too long, or the divisor is zero.
    pub fn quotient(self, divisor: Self) -> Option<Self> {
        let numerator = self.numerator.checked_mul(divisor.denominator)?;
        let denominator = self.denominator.checked_mul(divisor.numerator.abs())?;
        Self::new(numerator.checked_mul(divisor.numerator.signum())?, denominator)
    }

    /// The sum; `None` if it is too long.
    pub fn sum(self, other: Self) -> Option<Self> {
        let common = least_common_multiple(self.denominator, other.denominator)?;
        let [own, other] = [self, other].map(|fraction| {
            product(fraction.numerator, exact_quotient(common, fraction.denominator))
        });
        Self::new(own?.checked_add(other?)?, common)
    }
}

/// A series of cosines or of sines, with all harmonics `0, 1, 2, ...`, the even or the odd ones.
#[derive(Clone, Debug)]
pub struct ShortSeries {
    /// Cosines or sines; a sine of harmonic zero has the numerator zero.
    pub wave: Wave,
    harmonics: HarmonicParity,
    denominator: i128,
    numerators: Vec<i128>,
    /// The largest absolute value of a numerator, rounded.
    largest: f64,
}

/// The harmonics that a series stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HarmonicParity {
    /// `0, 1, 2, ...`
    All,
    /// `0, 2, 4, ...`
    Even,
    /// `1, 3, 5, ...`
    Odd,
}

impl HarmonicParity {
    /// The harmonic at a place.
    pub fn harmonic(self, index: usize) -> usize {
        match self {
            Self::All => index,
            Self::Even => 2 * index,
            Self::Odd => 2 * index + 1,
        }
    }

    /// The harmonics of a product of two series.
    pub fn times(self, other: Self) -> Self {
        match (self, other) {
            (Self::All, _) | (_, Self::All) => Self::All,
            _ if self == other => Self::Even,
            _ => Self::Odd,
        }
    }
}

impl ShortSeries {
    /// A series from numerators over a positive denominator; `None` if they are too long.
    pub fn new(
        wave: Wave,
        harmonics: HarmonicParity,
        denominator: i128,
        numerators: Vec<i128>,
    ) -> Option<Self> {
        let largest = numerators.iter().map(|numerator| numerator.unsigned_abs()).max();
        let largest = size(largest.unwrap_or(0));
        (largest < BOUND && denominator > 0).then_some(Self {
            wave,
            harmonics,
            denominator,
            numerators,
            largest,
        })
    }

    /// A constant series; `harmonics` must be all or the even ones.
    pub fn constant(harmonics: HarmonicParity, numerator: i128, denominator: i128) -> Option<Self> {
        Self::new(Wave::Cosine, harmonics, denominator, vec![numerator])
    }

    /// The common denominator, positive.
    pub fn denominator(&self) -> i128 {
        self.denominator
    }

    /// The harmonics that are stored.
    pub fn harmonics(&self) -> HarmonicParity {
        self.harmonics
    }

    /// The numerators of the harmonics that may occur.
    pub fn numerators(&self) -> &[i128] {
        &self.numerators
    }

    /// The numerator at a place, zero beyond the last.
    pub fn numerator(&self, index: usize) -> i128 {
        self.numerators.get(index).copied().unwrap_or(0)
    }

    /// Whether every number is zero.
    pub fn is_zero(&self) -> bool {
        self.largest == 0.0
    }

    /// The coefficient at a place.
    pub fn coefficient(&self, index: usize) -> Option<ShortFraction> {
        ShortFraction::new(self.numerator(index), self.denominator)
    }

    /// Returns the series with another numerator at a place; `None` if it is too long.
    pub fn with_numerator(mut self, index: usize, numerator: i128) -> Option<Self> {
        if self.numerators.len() <= index {
            self.numerators.resize(index + 1, 0);
        }
        self.numerators[index] = numerator;
        Self::new(self.wave, self.harmonics, self.denominator, self.numerators)
    }

    /// Returns the series in lowest terms.
    pub fn reduced(mut self) -> Self {
        // Powers of two are cancelled first; mostly no other common factor is left.
        let all = self.numerators.iter().fold(0, |all, numerator| all | numerator);
        let halvings = self.denominator.trailing_zeros();
        let mut odd = self.denominator >> halvings;
        for numerator in &self.numerators {
            if odd == 1 {
                break;
            }
            odd = greatest_common_divisor(odd, *numerator);
        }
        let common = odd << halvings.min(all.trailing_zeros());
        if common > 1 {
            let shift = common.trailing_zeros();
            self.denominator = exact_quotient(self.denominator, common);
            self.largest /= size(common.unsigned_abs());
            for numerator in &mut self.numerators {
                *numerator >>= shift;
                if odd > 1 {
                    *numerator = quotient(*numerator, odd);
                }
            }
        }
        self
    }

    /// The derivative.
    pub fn derivative(&self) -> Option<Self> {
        match self.wave {
            Wave::Cosine => self.times_harmonics(Wave::Sine, |harmonic| -harmonic),
            Wave::Sine => self.times_harmonics(Wave::Cosine, |harmonic| harmonic),
        }
    }

    /// The second derivative.
    pub fn second_derivative(&self) -> Option<Self> {
        self.times_harmonics(self.wave, |harmonic| -(harmonic * harmonic))
    }

    fn times_harmonics(&self, wave: Wave, factor: impl Fn(i128) -> i128) -> Option<Self> {
        let mut numerators = Vec::with_capacity(self.numerators.len());
        for (index, numerator) in self.numerators.iter().enumerate() {
            let harmonic = u32::try_from(self.harmonics.harmonic(index)).ok()?;
            numerators.push(product(*numerator, factor(harmonic.into()))?);
        }
        Self::new(wave, self.harmonics, self.denominator, numerators)
    }

    /// The solution of `u'' + u = self` without first harmonic: every coefficient divided by
    /// `1 - k^2`.
    pub fn without_resonance_over_divisors(mut self) -> Option<Self> {
        // The remaining factor of each divisor after its common factor with the numerator is
        // cancelled.
        let mut zeros = Zeros::new();
        let left = zeros.take(self.numerators.len());
        let mut common = 1_i128;
        for (index, (numerator, left)) in self.numerators.iter_mut().zip(&mut *left).enumerate() {
            let harmonic = self.harmonics.harmonic(index) as i128;
            let divisor = harmonic * harmonic - 1;
            if divisor == 0 || *numerator == 0 {
                (*numerator, *left) = (0, 1);
                continue;
            }
            // The divisor of the zeroth harmonic is minus one, hence the absolute value.
            let shared = greatest_common_divisor(divisor.abs(), *numerator);
            *left = exact_quotient(divisor.abs(), shared);
            *numerator = exact_quotient(*numerator, shared) * -divisor.signum();
            common = least_common_multiple(common, *left)?;
        }
        if self.largest * size(common.unsigned_abs()) >= BOUND {
            return None;
        }
        if common > 1 {
            for (numerator, left) in self.numerators.iter_mut().zip(left) {
                *numerator = numerator.wrapping_mul(exact_quotient(common, *left));
            }
        }
        let denominator = product(self.denominator, common)?;
        Self::new(self.wave, self.harmonics, denominator, self.numerators)
    }
}

/// The number as a double, or a little more; most numbers fit one word, whose conversion is a single
/// instruction.
fn size(number: u128) -> f64 {
    const WORD: f64 = (1_u128 << 64) as f64;
    let high = (number >> 64) as u64;
    let above = if high > 0 { high as f64 + 1.0 } else { return number as u64 as f64 };
    above * WORD
}

/// The least power of two that is not below a number. As a bound of a factor it is at hand at once,
/// and it is the factor itself where denominators are powers of two.
fn power_of_two_above(number: u128) -> f64 {
    let digits = u128::BITS - number.saturating_sub(1).leading_zeros();
    f64::from_bits((1023 + u64::from(digits)) << 52)
}

/// Whether a positive number is a power of two.
fn is_power_of_two(number: i128) -> bool {
    number & (number - 1) == 0
}

/// Returns a quotient without remainder by a positive divisor. Most divisors are powers of two.
#[inline]
fn exact_quotient(number: i128, divisor: i128) -> i128 {
    match is_power_of_two(divisor) {
        true => number >> divisor.trailing_zeros(),
        false => quotient(number, divisor),
    }
}

/// The product; `None` if it is too long. Most numbers fit one word, whose product always fits.
fn product(left: i128, right: i128) -> Option<i128> {
    match (i64::try_from(left), i64::try_from(right)) {
        (Ok(left), Ok(right)) => Some(i128::from(left).wrapping_mul(i128::from(right))),
        _ => left.checked_mul(right),
    }
}

/// Returns a quotient; most numbers fit one word.
fn quotient(number: i128, divisor: i128) -> i128 {
    match (i64::try_from(number), i64::try_from(divisor)) {
        (Ok(number), Ok(divisor)) => i128::from(number / divisor),
        _ => number / divisor,
    }
}

/// Greatest common divisor of a positive number and any other.
fn greatest_common_divisor(left: i128, right: i128) -> i128 {
    if is_power_of_two(left) {
        return 1 << left.trailing_zeros().min(right.trailing_zeros());
    }
    // Often one number divides the other, and a single division tells it.
    let rest = match (u64::try_from(left), u64::try_from(right.unsigned_abs())) {
        (Ok(left), Ok(right)) => i128::from(right % left),
        _ => (right % left).abs(),
    };
    if rest == 0 {
        return left;
    }
    let (left, rest) = (left.unsigned_abs(), rest.unsigned_abs());
    let halvings = (left | rest).trailing_zeros();
    (common_odd_divisor(left >> left.trailing_zeros(), rest >> rest.trailing_zeros()) << halvings)
        as i128
}

/// Greatest common divisor of two odd numbers. No branch but the end of a loop depends on them,
/// because nothing could foretell it.
fn common_odd_divisor(mut smaller: u128, mut other: u128) -> u128 {
    while smaller != other {
        if let (Ok(mut smaller), Ok(mut other)) = (u64::try_from(smaller), u64::try_from(other)) {
            while smaller != other {
                let difference = smaller.abs_diff(other);
                smaller = smaller.min(other);
                other = difference >> difference.trailing_zeros();
            }
            return smaller.into();
        }
        let difference = smaller.abs_diff(other);
        smaller = smaller.min(other);
        other = difference >> difference.trailing_zeros();
    }
    smaller
}

/// Least common multiple of positive numbers.
fn least_common_multiple(left: i128, right: i128) -> Option<i128> {
    if left == right || right == 1 {
        return Some(left);
    }
    if left == 1 || (is_power_of_two(left) && is_power_of_two(right)) {
        return Some(left.max(right));
    }
    // Mostly one is a multiple of the other, and a single division tells it.
    let (larger, smaller) = (left.max(right), left.min(right));
    let rest = match (u64::try_from(larger), u64::try_from(smaller)) {
        (Ok(larger), Ok(smaller)) => i128::from(larger % smaller),
        _ => larger % smaller,
    };
    match rest {
        0 => Some(larger),
        _ => exact_quotient(larger, greatest_common_divisor(smaller, rest)).checked_mul(smaller),
    }
}

/// `sum of (numerator / denominator) series`; all series must have the same kind of waves.
pub fn combination(terms: &[(i128, i128, &ShortSeries)]) -> Option<ShortSeries> {
    let first = terms.first()?.2;
    let mut common = 1;
    let mut length = 0;
    for (_, denominator, series) in terms {
        common = least_common_multiple(common, product(*denominator, series.denominator)?)?;
        length = length.max(series.numerators.len());
    }
    let mut bound = 0.0;
    let mut zeros = Zeros::new();
    let sums = zeros.take(length);
    for (numerator, denominator, series) in terms {
        let own = denominator.wrapping_mul(series.denominator);
        let factor = product(*numerator, exact_quotient(common, own))?;
        let factor_size = power_of_two_above(factor.unsigned_abs());
        bound += factor_size * series.largest;
        if bound >= BOUND {
            return None;
        }
        let pairs = sums.iter_mut().zip(&series.numerators);
        match factor_size.max(series.largest) < WORD {
            true => pairs.for_each(|(sum, own)| *sum = sum.wrapping_add(of_words(factor, *own))),
            false => {
                pairs.for_each(|(sum, own)| *sum = sum.wrapping_add(factor.wrapping_mul(*own)))
            }
        }
    }
    ShortSeries::new(first.wave, first.harmonics, common, sums.to_vec())
}

/// `sum_i left_i right_(n-i)` over two lists of the same length; all products must have the same
/// kind of waves.
pub fn convolution(left: &[ShortSeries], right: &[ShortSeries]) -> Option<ShortSeries> {
    let last = right.len().checked_sub(1)?;
    let terms = left.iter().enumerate().map(|(i, left)| (1, left, &right[last - i]));
    sum_of_products(terms)
}

/// `sum_i series_i series_(n-i)`, each pair once.
pub fn square(series: &[ShortSeries]) -> Option<ShortSeries> {
    let last = series.len().checked_sub(1)?;
    let terms =
        (0..=last / 2).map(|i| (if 2 * i == last { 1 } else { 2 }, &series[i], &series[last - i]));
    sum_of_products(terms)
}

/// `sum of weight left right`; all products must have the same kind of waves.
fn sum_of_products<'a>(
    terms: impl Iterator<Item = (i128, &'a ShortSeries, &'a ShortSeries)> + Clone,
) -> Option<ShortSeries> {
    let mut common = 1;
    let mut length = 1;
    let mut kind = (Wave::Cosine, HarmonicParity::Even);
    for (_, left, right) in terms.clone() {
        common = least_common_multiple(common, product(left.denominator, right.denominator)?)?;
        length = length.max(left.numerators.len() + right.numerators.len());
        let wave = if left.wave == right.wave { Wave::Cosine } else { Wave::Sine };
        kind = (wave, left.harmonics.times(right.harmonics));
    }
    let mut bound = 0.0;
    // The sums of the harmonics' sums and, behind them, of their differences.
    let mut zeros = Zeros::new();
    let (upper, lower) = zeros.take(2 * length).split_at_mut(length);
    for (weight, left, right) in terms {
        let own = left.denominator.wrapping_mul(right.denominator);
        let factor = product(weight, exact_quotient(common, own))?;
        let (short, long) = match left.numerators.len() <= right.numerators.len() {
            true => (left, right),
            false => (right, left),
        };
        let largest = power_of_two_above(factor.unsigned_abs()) * short.largest;
        // Every harmonic of the result gets at most one term from sums of harmonics and two from
        // differences per coefficient of the shorter factor.
        bound += largest * long.largest * (3 * short.numerators.len()) as f64;
        if bound >= BOUND {
            return None;
        }
        let (sums, pair) = ((&mut *upper, &mut *lower), (short, long));
        // If a factor fits one word, its products take a third of the instructions, or one.
        match (largest < WORD, long.largest < WORD) {
            (true, true) => add_doubled_product(sums, factor, pair, of_words),
            (true, false) => add_doubled_product(sums, factor, pair, word_times),
            (false, true) => add_doubled_product(sums, factor, pair, times_word),
            _ => add_doubled_product(sums, factor, pair, i128::wrapping_mul),
        }
    }
    for (upper, lower) in upper.iter_mut().zip(lower) {
        *upper = upper.wrapping_add(*lower);
    }
    if kind.0 == Wave::Sine && kind.1 != HarmonicParity::Odd {
        upper[0] = 0;
    }
    let last = upper.iter().rposition(|sum| *sum != 0).unwrap_or(0);
    ShortSeries::new(kind.0, kind.1, product(common, 2)?, upper[..=last].to_vec())
}

/// The product of two numbers that fit one word.
fn of_words(left: i128, right: i128) -> i128 {
    i128::from(left as i64).wrapping_mul(i128::from(right as i64))
}

/// The product of a number that fits one word and any other.
fn word_times(left: i128, right: i128) -> i128 {
    i128::from(left as i64).wrapping_mul(right)
}

/// The product of any number and one that fits one word.
fn times_word(left: i128, right: i128) -> i128 {
    left.wrapping_mul(i128::from(right as i64))
}

/// Adds twice a product by `2 cos i cos j = cos(i+j) + cos(i-j)` and the similar formulas with
/// sines, the sums of harmonics and their differences apart; fast if the longer factor is the
/// second.
fn add_doubled_product(
    (upper, lower): (&mut [i128], &mut [i128]),
    factor: i128,
    (short, long): (&ShortSeries, &ShortSeries),
    multiply: impl Fn(i128, i128) -> i128 + Copy,
) {
    use HarmonicParity::{Even, Odd};
    let both_odd = short.harmonics == Odd && long.harmonics == Odd;
    let apart = short.harmonics != long.harmonics;
    let [short_is_sine, long_is_sine] = [short, long].map(|series| series.wave == Wave::Sine);
    let signed = |negative: bool, number: i128| {
        if negative { number.wrapping_neg() } else { number }
    };
    // The sine of a difference takes the sign of that difference.
    let upper_is_negative = short_is_sine && long_is_sine;
    let above_is_opposite = upper_is_negative != (short_is_sine && !long_is_sine);
    let below_is_opposite = upper_is_negative != (long_is_sine && !short_is_sine);
    for (place, own) in short.numerators.iter().enumerate() {
        let own = signed(upper_is_negative, own.wrapping_mul(factor));
        if own == 0 {
            continue;
        }
        let split = place + usize::from(apart && long.harmonics == Even);
        let (below, above) = long.numerators.split_at(split.min(long.numerators.len()));
        let (near, far) = upper[place + usize::from(both_odd)..].split_at_mut(below.len());
        let differences = lower.iter_mut();
        for ((upper, lower), other) in far.iter_mut().zip(differences).zip(above) {
            let product = multiply(own, *other);
            *upper = upper.wrapping_add(product);
            *lower = lower.wrapping_add(signed(above_is_opposite, product));
        }
        // The last of those below is nearest to this place.
        let differences = lower.iter_mut().skip(usize::from(!apart) + split - below.len());
        let pairs = near.iter_mut().rev().zip(differences);
        for ((upper, lower), other) in pairs.zip(below.iter().rev()) {
            let product = multiply(own, *other);
            *upper = upper.wrapping_add(product);
            *lower = lower.wrapping_add(signed(below_is_opposite, product));
        }
    }
}

#[cfg(test)]
mod tests {
    use num_integer::Integer as _;

    use super::super::fourier::{self, FourierSeries};
    use super::*;
    use crate::exact::{Integer, Integers, Rational};

    /// The series with integers of any length.
    fn long(series: &ShortSeries) -> FourierSeries<Integers> {
        let mut coefficients = vec![];
        for (index, numerator) in series.numerators.iter().enumerate() {
            coefficients.resize(series.harmonics.harmonic(index), Integer::from(0));
            coefficients.push(Integer::from(*numerator));
        }
        let (cosine, sine) = match series.wave {
            Wave::Cosine => (coefficients, vec![]),
            Wave::Sine => (vec![], coefficients),
        };
        FourierSeries::from_parts(Integers, cosine, sine).over(&Integer::from(series.denominator))
    }

    /// Series of both waves and all kinds of harmonics, with numerators that are not multiples of
    /// each other.
    fn examples() -> Vec<ShortSeries> {
        let mut examples = vec![];
        for wave in [Wave::Cosine, Wave::Sine] {
            for harmonics in [HarmonicParity::All, HarmonicParity::Even, HarmonicParity::Odd] {
                for (length, denominator) in [(1, 3), (4, 32), (7, 90)] {
                    let mut numerators: Vec<i128> =
                        (0..length).map(|k| k * k * k - 9 * k + 5).collect();
                    if wave == Wave::Sine && harmonics != HarmonicParity::Odd {
                        numerators[0] = 0;
                    }
                    examples.push(
                        ShortSeries::new(wave, harmonics, denominator, numerators).expect("short"),
                    );
                }
            }
        }
        examples
    }

    #[test]
    fn short_series_are_those_of_any_length() {
        let mut products = 0;
        for left in examples() {
            assert_eq!(long(&left.clone().reduced()), long(&left));
            assert_eq!(long(&left.derivative().expect("short")), long(&left).derivative());
            let second = left.second_derivative().expect("short");
            assert_eq!(long(&second), long(&left).derivative().derivative());
            let solution = left.clone().without_resonance_over_divisors().expect("short");
            assert_eq!(long(&solution), long(&left).solve_oscillator().0);
            for right in examples() {
                let mixed = (left.harmonics == HarmonicParity::All)
                    != (right.harmonics == HarmonicParity::All);
                if mixed {
                    continue;
                }
                products += 1;
                let product = sum_of_products([(3, &left, &right)].into_iter()).expect("short");
                let expected =
                    fourier::sum_of_products(&Integers, &[(3, &long(&left), &long(&right))]);
                assert_eq!(long(&product), expected, "{left:?} {right:?}");
                let [left_right, right_left] =
                    [[left.clone(), right.clone()], [right.clone(), left.clone()]];
                let sums =
                    [convolution(&left_right, &left_right), convolution(&left_right, &right_left)];
                let expected = [
                    vec![(2, &long(&left), &long(&right))],
                    vec![(1, &long(&left), &long(&left)), (1, &long(&right), &long(&right))],
                ]
                .map(|terms| fourier::sum_of_products(&Integers, &terms));
                let same_waves = (left.wave, left.harmonics) == (right.wave, right.harmonics);
                assert_eq!(long(sums[0].as_ref().expect("short")), expected[0]);
                assert_eq!(long(&square(&left_right).expect("short")), expected[0]);
                if same_waves {
                    assert_eq!(long(sums[1].as_ref().expect("short")), expected[1]);
                }
                if (left.wave, left.harmonics) == (right.wave, right.harmonics) {
                    let sum = combination(&[(2, 7, &left), (-5, 1, &right)]).expect("short");
                    let expected = fourier::linear_combination(
                        &Integers,
                        &[(2, &long(&left).divided_by(7)), (-5, &long(&right))],
                    );
                    assert_eq!(long(&sum), expected);
                }
            }
        }
        assert!(products > 100);
    }

    #[test]
    fn common_divisors_are_those_of_any_length() {
        let wide = 3_i128.pow(50);
        let numbers =
            [1, 2, 3, 12, 35, 96, 1 << 40, (1 << 61) - 1, 3_i128.pow(39), wide, 10 * wide];
        for left in numbers {
            for right in numbers.into_iter().chain([0, 7 << 100]) {
                for right in [right, -right] {
                    let found = greatest_common_divisor(left, right);
                    assert_eq!(found, left.gcd(&right), "{left} {right}");
                }
            }
        }
    }

    #[test]
    fn short_fractions_are_those_of_any_length() {
        let long = |own: ShortFraction| Rational::new(own.numerator.into(), own.denominator.into());
        let wide = (1_i128 << 70) + 3;
        let numbers =
            [(0, 5), (1, 1), (-6, 4), (35, 12), (7 << 66, 96), (wide, 3 * wide), (-9, wide)];
        let fractions = numbers.map(|(numerator, denominator)| {
            let own = ShortFraction::new(numerator, denominator).expect("short");
            assert_eq!(long(own), Rational::new(numerator.into(), denominator.into()));
            assert_eq!(Integer::from(own.denominator()), *long(own).denom());
            assert_eq!(Integer::from(own.numerator()), *long(own).numer());
            assert_eq!(long(own.negative()), -long(own));
            own
        });
        for left in fractions {
            for right in fractions {
                let check = |found: Option<ShortFraction>, expected: Rational| match found {
                    Some(found) => assert_eq!(long(found), expected),
                    None => assert!(expected.numer().bits() + expected.denom().bits() > 126),
                };
                check(left.sum(right), long(left) + long(right));
                check(left.product(right), long(left) * long(right));
                match right.is_zero() {
                    true => assert_eq!(left.quotient(right), None),
                    false => check(left.quotient(right), long(left) / long(right)),
                }
            }
        }
        assert_eq!(ShortFraction::new(1, 0), None);
        assert_eq!(ShortFraction::new(i128::MIN, 3), None);
    }

    #[test]
    fn what_does_not_fit_is_no_series() {
        let half = 1 << 63;
        let long = ShortSeries::new(Wave::Cosine, HarmonicParity::Odd, 1, vec![half, half])
            .expect("half of it");
        assert!(square(std::slice::from_ref(&long)).is_none());
        assert!(combination(&[(half, 1, &long)]).is_none());
        assert!(combination(&[(1, half, &long), (1, half - 1, &long)]).is_none());
        assert!(ShortSeries::new(Wave::Cosine, HarmonicParity::Odd, 1, vec![i128::MIN]).is_none());
        let prime = (1 << 61) - 1;
        let far =
            ShortSeries::new(Wave::Cosine, HarmonicParity::All, 1, vec![prime; 60]).expect("short");
        assert!(far.without_resonance_over_divisors().is_none());
    }
}

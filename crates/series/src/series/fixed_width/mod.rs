//! Short Fourier series: numerators of two machine words over one denominator, without symbols and
//! without heap memory for each series.
//!
//! The size of a result is bounded beforehand from the largest numerators of the arguments. If the
//! bound exceeds two words, the operation returns `None`: no result is ever wrong, and no addition
//! or multiplication has to check for overflow.
//!
//! Every operation writes its result into a [`SeriesBuffer`], and what is kept goes to the end of a
//! [`ShortSeriesList`]: an expansion allocates its lists once.

mod fraction;

pub use fraction::ShortFraction;

use super::waves::Wave;
use fraction::{
    BOUND, exact_quotient, greatest_common_divisor, least_common_multiple, power_of_two_above,
    product, quotient, size,
};

/// Bound of the numbers that fit one word, whose product is a single instruction; with the same
/// room.
const WORD: f64 = (1_u64 << 62) as f64;

/// A series of cosines or of sines, with all harmonics `0, 1, 2, ...`, the even or the odd ones; its
/// numerators stand in a [list](ShortSeriesList) or a [buffer](SeriesBuffer).
#[derive(Clone, Copy, Debug)]
pub struct ShortSeries<'a> {
    header: Header,
    numerators: &'a [i128],
}

/// Everything of a series but its numerators.
#[derive(Clone, Copy, Debug)]
struct Header {
    /// Cosines or sines; a sine of harmonic zero has the numerator zero.
    wave: Wave,
    harmonics: HarmonicParity,
    denominator: i128,
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

impl<'a> ShortSeries<'a> {
    /// A series from numerators over a positive denominator; `None` if they are too long.
    pub fn new(
        wave: Wave,
        harmonics: HarmonicParity,
        denominator: i128,
        numerators: &'a [i128],
    ) -> Option<Self> {
        let largest = numerators.iter().map(|numerator| numerator.unsigned_abs()).max();
        let largest = size(largest.unwrap_or(0));
        (largest < BOUND && denominator > 0).then_some(Self {
            header: Header { wave, harmonics, denominator, largest },
            numerators,
        })
    }

    /// The series zero.
    pub fn zero(wave: Wave, harmonics: HarmonicParity) -> Self {
        Self { header: Header { wave, harmonics, denominator: 1, largest: 0.0 }, numerators: &[] }
    }

    /// Cosines or sines.
    pub fn wave(self) -> Wave {
        self.header.wave
    }

    /// The common denominator, positive.
    pub fn denominator(self) -> i128 {
        self.header.denominator
    }

    /// The harmonics that are stored.
    pub fn harmonics(self) -> HarmonicParity {
        self.header.harmonics
    }

    /// The numerators of the harmonics that may occur.
    pub fn numerators(self) -> &'a [i128] {
        self.numerators
    }

    /// The numerator at a place, zero beyond the last.
    pub fn numerator(self, index: usize) -> i128 {
        self.numerators.get(index).copied().unwrap_or(0)
    }

    /// Whether every number is zero.
    pub fn is_zero(self) -> bool {
        self.header.largest == 0.0
    }

    /// The coefficient at a place.
    pub fn coefficient(self, index: usize) -> Option<ShortFraction> {
        ShortFraction::new(self.numerator(index), self.header.denominator)
    }
}

/// Series one after the other, with all their numerators in one piece of memory.
#[derive(Clone, Debug, Default)]
pub struct ShortSeriesList {
    /// Each series, and the end of its numerators.
    series: Vec<(Header, usize)>,
    numerators: Vec<i128>,
}

impl ShortSeriesList {
    /// An empty list with room for so many series and numerators.
    pub fn with_capacity(series: usize, numerators: usize) -> Self {
        Self { series: Vec::with_capacity(series), numerators: Vec::with_capacity(numerators) }
    }

    /// Number of series.
    pub fn len(&self) -> usize {
        self.series.len()
    }

    /// Whether there are no series.
    pub fn is_empty(&self) -> bool {
        self.series.is_empty()
    }

    /// The series at a place; `None` beyond the last.
    pub fn get(&self, index: usize) -> Option<ShortSeries<'_>> {
        (index < self.len()).then(|| self.known(index))
    }

    /// The series at a place that there is.
    #[inline]
    fn known(&self, index: usize) -> ShortSeries<'_> {
        let (header, end) = self.series[index];
        let start = if index == 0 { 0 } else { self.series[index - 1].1 };
        ShortSeries { header, numerators: &self.numerators[start..end] }
    }

    /// Appends a series.
    pub fn push(&mut self, series: ShortSeries) {
        self.numerators.extend_from_slice(series.numerators);
        self.series.push((series.header, self.numerators.len()));
    }

    /// Replaces the last series.
    pub fn replace_last(&mut self, series: ShortSeries) {
        self.series.pop();
        self.numerators.truncate(self.series.last().map_or(0, |(_, end)| *end));
        self.push(series);
    }
}

/// The result of an operation, in memory that serves one operation after the other.
///
/// An operation that returns `None`, because a number is too long, leaves no series.
#[derive(Clone, Debug)]
pub struct SeriesBuffer {
    header: Header,
    numerators: Vec<i128>,
    /// Numbers beside the numerators: sums of differences of harmonics, divisors.
    others: Vec<i128>,
}

impl Default for SeriesBuffer {
    fn default() -> Self {
        Self::with_capacity(0)
    }
}

impl SeriesBuffer {
    /// A series without terms, with room for so many.
    pub fn with_capacity(count: usize) -> Self {
        Self {
            header: ShortSeries::zero(Wave::Cosine, HarmonicParity::All).header,
            numerators: Vec::with_capacity(count),
            others: Vec::with_capacity(count),
        }
    }

    /// The series.
    pub fn series(&self) -> ShortSeries<'_> {
        ShortSeries { header: self.header, numerators: &self.numerators }
    }

    /// Sets the header of the numerators; `None` if they are too long.
    fn finish(&mut self, wave: Wave, harmonics: HarmonicParity, denominator: i128) -> Option<()> {
        self.header = ShortSeries::new(wave, harmonics, denominator, &self.numerators)?.header;
        Some(())
    }

    /// Sets a copy of a series.
    pub fn set(&mut self, series: ShortSeries) {
        self.numerators.clear();
        self.numerators.extend_from_slice(series.numerators);
        self.header = series.header;
    }

    /// Changes the numerator at a place; `None` if it is too long.
    pub fn set_numerator(&mut self, index: usize, numerator: i128) -> Option<()> {
        if self.numerators.len() <= index {
            self.numerators.resize(index + 1, 0);
        }
        self.numerators[index] = numerator;
        let Header { wave, harmonics, denominator, .. } = self.header;
        self.finish(wave, harmonics, denominator)
    }

    /// Reduces the series to lowest terms.
    pub fn reduce(&mut self) {
        // Powers of two are cancelled first; mostly no other common factor is left.
        let all = self.numerators.iter().fold(0, |all, numerator| all | numerator);
        let denominator = self.header.denominator;
        let halvings = denominator.trailing_zeros();
        let mut odd = denominator >> halvings;
        for numerator in &self.numerators {
            if odd == 1 {
                break;
            }
            odd = greatest_common_divisor(odd, *numerator);
        }
        let common = odd << halvings.min(all.trailing_zeros());
        if common > 1 {
            let shift = common.trailing_zeros();
            self.header.denominator = exact_quotient(denominator, common);
            self.header.largest /= size(common.unsigned_abs());
            for numerator in &mut self.numerators {
                *numerator >>= shift;
                if odd > 1 {
                    *numerator = quotient(*numerator, odd);
                }
            }
        }
    }

    /// Multiplies the series by a fraction with a positive denominator, and reduces it to lowest
    /// terms; `None` if it is too long.
    pub fn multiply(&mut self, numerator: i128, denominator: i128) -> Option<()> {
        let Header { wave, harmonics, denominator: own, largest } = self.header;
        if largest * size(numerator.unsigned_abs()) >= BOUND {
            return None;
        }
        for own in &mut self.numerators {
            *own = own.wrapping_mul(numerator);
        }
        self.finish(wave, harmonics, product(own, denominator)?)?;
        self.reduce();
        Some(())
    }

    /// Sets the derivative of a series; `None` if it is too long.
    pub fn set_derivative(&mut self, series: ShortSeries) -> Option<()> {
        match series.wave() {
            Wave::Cosine => self.set_times_harmonics(series, Wave::Sine, |harmonic| -harmonic),
            Wave::Sine => self.set_times_harmonics(series, Wave::Cosine, |harmonic| harmonic),
        }
    }

    /// Sets the second derivative of a series; `None` if it is too long.
    pub fn set_second_derivative(&mut self, series: ShortSeries) -> Option<()> {
        self.set_times_harmonics(series, series.wave(), |harmonic| -(harmonic * harmonic))
    }

    fn set_times_harmonics(
        &mut self,
        series: ShortSeries,
        wave: Wave,
        factor: impl Fn(i128) -> i128,
    ) -> Option<()> {
        self.numerators.clear();
        let harmonics = series.harmonics();
        for (index, numerator) in series.numerators.iter().enumerate() {
            let harmonic = u32::try_from(harmonics.harmonic(index)).ok()?;
            self.numerators.push(product(*numerator, factor(harmonic.into()))?);
        }
        self.finish(wave, harmonics, series.denominator())
    }

    /// Replaces the series by its derivative; `None` if that is too long.
    pub fn differentiate(&mut self) -> Option<()> {
        let Header { wave, harmonics, denominator, .. } = self.header;
        let sign = if wave == Wave::Cosine { -1 } else { 1 };
        for (index, numerator) in self.numerators.iter_mut().enumerate() {
            let harmonic = u32::try_from(harmonics.harmonic(index)).ok()?;
            *numerator = product(*numerator, sign * i128::from(harmonic))?;
        }
        self.finish(wave.other(), harmonics, denominator)
    }

    /// Replaces the series by the solution of `u'' + u = series` without first harmonic: every
    /// coefficient divided by `1 - k^2`; `None` if it is too long.
    pub fn divide_by_divisors_without_resonance(&mut self) -> Option<()> {
        // The remaining factor of each divisor after its common factor with the numerator is
        // cancelled.
        let Header { wave, harmonics, denominator, largest } = self.header;
        self.others.clear();
        let mut common = 1_i128;
        for (index, numerator) in self.numerators.iter_mut().enumerate() {
            let harmonic = harmonics.harmonic(index) as i128;
            let divisor = harmonic * harmonic - 1;
            if divisor == 0 || *numerator == 0 {
                *numerator = 0;
                self.others.push(1);
                continue;
            }
            // The divisor of the zeroth harmonic is minus one, hence the absolute value.
            let shared = greatest_common_divisor(divisor.abs(), *numerator);
            let left = exact_quotient(divisor.abs(), shared);
            *numerator = exact_quotient(*numerator, shared) * -divisor.signum();
            self.others.push(left);
            common = least_common_multiple(common, left)?;
        }
        if largest * size(common.unsigned_abs()) >= BOUND {
            return None;
        }
        if common > 1 {
            for (numerator, left) in self.numerators.iter_mut().zip(&self.others) {
                *numerator = numerator.wrapping_mul(exact_quotient(common, *left));
            }
        }
        self.finish(wave, harmonics, product(denominator, common)?)
    }

    /// Sets `sum of (numerator / denominator) series`; all series must have the same kind of waves.
    /// `None` if it is too long or there are no terms.
    pub fn set_combination(&mut self, terms: &[(i128, i128, ShortSeries)]) -> Option<()> {
        let mut common = 1;
        let mut length = 0;
        let first = terms.first()?.2;
        for (_, denominator, series) in terms {
            common = least_common_multiple(common, product(*denominator, series.denominator())?)?;
            length = length.max(series.numerators.len());
        }
        let mut bound = 0.0;
        self.numerators.clear();
        self.numerators.resize(length, 0);
        for (numerator, denominator, series) in terms {
            let own = denominator.wrapping_mul(series.denominator());
            let factor = product(*numerator, exact_quotient(common, own))?;
            let factor_size = power_of_two_above(factor.unsigned_abs());
            bound += factor_size * series.header.largest;
            if bound >= BOUND {
                return None;
            }
            let pairs = self.numerators.iter_mut().zip(series.numerators);
            match factor_size.max(series.header.largest) < WORD {
                true => {
                    pairs.for_each(|(sum, own)| *sum = sum.wrapping_add(of_words(factor, *own)))
                }
                false => {
                    pairs.for_each(|(sum, own)| *sum = sum.wrapping_add(factor.wrapping_mul(*own)))
                }
            }
        }
        self.finish(first.wave(), first.harmonics(), common)
    }

    /// Sets `sum of left_i right_(last - i)` over `first <= i <= last`; all products must have the
    /// same kind of waves. `None` if it is too long, or there are not so many series.
    pub fn set_convolution(
        &mut self,
        left: &ShortSeriesList,
        right: &ShortSeriesList,
        first: usize,
        last: usize,
    ) -> Option<()> {
        if last >= left.len() || last.checked_sub(first)? >= right.len() {
            return None;
        }
        let term = |i: usize| (1, left.known(i), right.known(last - i));
        self.set_sum_of_products((first..=last).map(term))
    }

    /// Sets `sum of series_i series_(last - i)`, each pair once; `None` as for a
    /// [convolution](Self::set_convolution).
    pub fn set_square(&mut self, series: &ShortSeriesList, last: usize) -> Option<()> {
        if last >= series.len() {
            return None;
        }
        let term = |i: usize| {
            let weight = if 2 * i == last { 1 } else { 2 };
            (weight, series.known(i), series.known(last - i))
        };
        self.set_sum_of_products((0..=last / 2).map(term))
    }

    /// Sets a product; `None` if it is too long.
    pub fn set_product(&mut self, left: ShortSeries, right: ShortSeries) -> Option<()> {
        self.set_sum_of_products(std::iter::once((1, left, right)))
    }

    /// Sets `sum of weight left right`; all products must have the same kind of waves.
    fn set_sum_of_products<'a>(
        &mut self,
        terms: impl Iterator<Item = (i128, ShortSeries<'a>, ShortSeries<'a>)> + Clone,
    ) -> Option<()> {
        let mut common = 1;
        let mut length = 1;
        let mut kind = (Wave::Cosine, HarmonicParity::Even);
        for (_, left, right) in terms.clone() {
            let own = product(left.denominator(), right.denominator())?;
            common = least_common_multiple(common, own)?;
            length = length.max(left.numerators.len() + right.numerators.len());
            let wave = if left.wave() == right.wave() { Wave::Cosine } else { Wave::Sine };
            kind = (wave, left.harmonics().times(right.harmonics()));
        }
        let mut bound = 0.0;
        // The sums of the harmonics' sums and, apart, of their differences.
        let Self { numerators: upper, others: lower, .. } = self;
        for sums in [&mut *upper, &mut *lower] {
            sums.clear();
            sums.resize(length, 0);
        }
        for (weight, left, right) in terms {
            let own = left.denominator().wrapping_mul(right.denominator());
            let factor = product(weight, exact_quotient(common, own))?;
            let (short, long) = match left.numerators.len() <= right.numerators.len() {
                true => (left, right),
                false => (right, left),
            };
            let largest = power_of_two_above(factor.unsigned_abs()) * short.header.largest;
            // Every harmonic of the result gets at most one term from sums of harmonics and two from
            // differences per coefficient of the shorter factor.
            bound += largest * long.header.largest * (3 * short.numerators.len()) as f64;
            if bound >= BOUND {
                return None;
            }
            let (sums, pair) = ((&mut upper[..], &mut lower[..]), (short, long));
            // If a factor fits one word, its products take a third of the instructions, or one.
            match (largest < WORD, long.header.largest < WORD) {
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
        upper.truncate(last + 1);
        self.finish(kind.0, kind.1, product(common, 2)?)
    }
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
    (short, long): (ShortSeries, ShortSeries),
    multiply: impl Fn(i128, i128) -> i128 + Copy,
) {
    use HarmonicParity::{Even, Odd};
    let both_odd = short.harmonics() == Odd && long.harmonics() == Odd;
    let apart = short.harmonics() != long.harmonics();
    let [short_is_sine, long_is_sine] = [short, long].map(|series| series.wave() == Wave::Sine);
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
        let split = place + usize::from(apart && long.harmonics() == Even);
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
    use super::super::fourier::{self, FourierSeries};
    use super::*;
    use crate::exact::{Integer, Integers};

    /// The series with integers of any length.
    fn long(series: ShortSeries) -> FourierSeries<Integers> {
        let mut coefficients = vec![];
        for (index, numerator) in series.numerators().iter().enumerate() {
            coefficients.resize(series.harmonics().harmonic(index), Integer::from(0));
            coefficients.push(Integer::from(*numerator));
        }
        let (cosine, sine) = match series.wave() {
            Wave::Cosine => (coefficients, vec![]),
            Wave::Sine => (vec![], coefficients),
        };
        FourierSeries::from_parts(Integers, cosine, sine).over(&Integer::from(series.denominator()))
    }

    /// The result of an operation.
    fn found(operation: impl Fn(&mut SeriesBuffer) -> Option<()>) -> FourierSeries<Integers> {
        let mut buffer = SeriesBuffer::default();
        // The buffer is not empty, as it is not in use.
        buffer.set_numerator(20, 17).expect("short");
        operation(&mut buffer).expect("short");
        long(buffer.series())
    }

    fn list(series: &[ShortSeries]) -> ShortSeriesList {
        let mut list = ShortSeriesList::default();
        series.iter().for_each(|series| list.push(*series));
        list
    }

    /// Series of both waves and all kinds of harmonics, with numerators that are not multiples of
    /// each other.
    fn examples() -> ShortSeriesList {
        let mut examples = ShortSeriesList::default();
        for wave in [Wave::Cosine, Wave::Sine] {
            for harmonics in [HarmonicParity::All, HarmonicParity::Even, HarmonicParity::Odd] {
                for (length, denominator) in [(1, 3), (4, 32), (7, 90)] {
                    let mut numerators: Vec<i128> =
                        (0..length).map(|k| k * k * k - 9 * k + 5).collect();
                    if wave == Wave::Sine && harmonics != HarmonicParity::Odd {
                        numerators[0] = 0;
                    }
                    let series = ShortSeries::new(wave, harmonics, denominator, &numerators);
                    examples.push(series.expect("short"));
                }
            }
        }
        examples
    }

    #[test]
    fn short_series_are_those_of_any_length() {
        let mut products = 0;
        let examples = examples();
        let all = || (0..examples.len()).map(|index| examples.get(index).expect("an example"));
        for left in all() {
            let changed = |change: fn(&mut SeriesBuffer) -> Option<()>| {
                found(|buffer| {
                    buffer.set(left);
                    change(buffer)
                })
            };
            let derivative = long(left).derivative();
            assert_eq!(
                changed(|buffer| {
                    buffer.reduce();
                    Some(())
                }),
                long(left)
            );
            assert_eq!(changed(SeriesBuffer::differentiate), derivative);
            assert_eq!(found(|buffer| buffer.set_derivative(left)), derivative);
            let second = found(|buffer| buffer.set_second_derivative(left));
            assert_eq!(second, derivative.derivative());
            let solution = changed(SeriesBuffer::divide_by_divisors_without_resonance);
            assert_eq!(solution, long(left).solve_oscillator().0);
            for right in all() {
                let mixed = (left.harmonics() == HarmonicParity::All)
                    != (right.harmonics() == HarmonicParity::All);
                if mixed {
                    continue;
                }
                products += 1;
                let (long_left, long_right) = (long(left), long(right));
                let sum =
                    found(|buffer| buffer.set_sum_of_products(std::iter::once((3, left, right))));
                let expected = fourier::sum_of_products(&Integers, &[(3, &long_left, &long_right)]);
                assert_eq!(sum, expected, "{left:?} {right:?}");
                let product = found(|buffer| buffer.set_product(left, right));
                assert_eq!(product, long_left.product(&long_right));
                let (forth, back) = (list(&[left, right]), list(&[right, left]));
                let twice = fourier::sum_of_products(&Integers, &[(2, &long_left, &long_right)]);
                let convolution = |other: &ShortSeriesList, first| {
                    found(|buffer| buffer.set_convolution(&forth, other, first, 1))
                };
                assert_eq!(convolution(&forth, 0), twice);
                assert_eq!(convolution(&forth, 1), long_right.product(&long_left));
                assert_eq!(found(|buffer| buffer.set_square(&forth, 1)), twice);
                if (left.wave(), left.harmonics()) == (right.wave(), right.harmonics()) {
                    let squares = [(1, &long_left, &long_left), (1, &long_right, &long_right)];
                    let expected = fourier::sum_of_products(&Integers, &squares);
                    assert_eq!(convolution(&back, 0), expected);
                    let terms = [(2, 7, left), (-5, 1, right)];
                    let sum = found(|buffer| buffer.set_combination(&terms));
                    let expected = fourier::linear_combination(
                        &Integers,
                        &[(2, &long_left.divided_by(7)), (-5, &long_right)],
                    );
                    assert_eq!(sum, expected);
                }
            }
        }
        assert!(products > 100);
    }

    #[test]
    fn a_list_keeps_its_series_apart() {
        let numerators = [[1, 2, 3], [4, 5, 6], [7, 8, 9]];
        let series = |index: usize, length: usize| {
            let numerators = &numerators[index][..length];
            ShortSeries::new(Wave::Sine, HarmonicParity::Odd, 11, numerators).expect("short")
        };
        let mut list = list(&[series(0, 3), series(1, 0), series(2, 1)]);
        list.replace_last(series(1, 2));
        list.push(series(2, 3));
        let all = (0..5).map(|index| list.get(index).map(ShortSeries::numerators));
        let expected: [Option<&[i128]>; 5] =
            [Some(&[1, 2, 3]), Some(&[]), Some(&[4, 5]), Some(&[7, 8, 9]), None];
        assert!(all.eq(expected));
    }

    #[test]
    fn what_does_not_fit_is_no_series() {
        let odd = |numerators| ShortSeries::new(Wave::Cosine, HarmonicParity::Odd, 1, numerators);
        let mut buffer = SeriesBuffer::default();
        let half = 1 << 63;
        let halves = [half, half];
        let long = odd(&halves).expect("half of it");
        let squared = list(&[long]);
        assert!(buffer.set_square(&squared, 0).is_none());
        assert!(buffer.set_square(&squared, 1).is_none(), "there is one series");
        assert!(buffer.set_convolution(&squared, &squared, 0, 1).is_none());
        assert!(buffer.set_combination(&[(half, 1, long)]).is_none());
        let apart = [(1, half, long), (1, half - 1, long)];
        assert!(buffer.set_combination(&apart).is_none());
        assert!(buffer.set_combination(&[]).is_none());
        assert!(odd(&[i128::MIN]).is_none());
        let primes = [(1 << 61) - 1; 60];
        let far = ShortSeries::new(Wave::Cosine, HarmonicParity::All, 1, &primes).expect("short");
        buffer.set(far);
        assert!(buffer.divide_by_divisors_without_resonance().is_none());
    }
}

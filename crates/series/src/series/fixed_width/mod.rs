//! Short Fourier series: numerators of [one machine word or two](FixedWidth) over one denominator,
//! without symbols and without heap memory for each series.
//!
//! The size of a result is bounded beforehand from the largest numerators of the arguments. If the
//! bound exceeds that width, the operation returns `None`: no result is ever wrong, and no addition
//! or multiplication has to check for overflow.
//!
//! Every operation writes its result into a [`SeriesBuffer`], and what is kept goes to the end of a
//! [`ShortSeriesList`]: an expansion allocates its lists once.

mod fraction;
mod list;

pub use fraction::{FixedWidth, ShortFraction};
pub use list::ShortSeriesList;

use std::ops::Range;

use num_traits::cast;

use super::waves::Wave;
use fraction::{exact_quotient, greatest_common_divisor, least_common_multiple, twice};

/// Bound of the numbers that fit one word, whose product is a single instruction; with the same
/// room.
const WORD: f64 = (1_u64 << 62) as f64;

/// A series of cosines or of sines, with all harmonics `0, 1, 2, ...`, the even or the odd ones; its
/// numerators stand in a [list](ShortSeriesList) or a [buffer](SeriesBuffer).
#[derive(Clone, Copy, Debug)]
pub struct ShortSeries<'a, W = i128> {
    header: Header<W>,
    numerators: &'a [W],
}

/// Everything of a series but its numerators.
#[derive(Clone, Copy, Debug)]
struct Header<W> {
    /// Cosines or sines; a sine of harmonic zero has the numerator zero.
    wave: Wave,
    harmonics: HarmonicParity,
    denominator: W,
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

impl<'a, W: FixedWidth> ShortSeries<'a, W> {
    /// A series from numerators over a positive denominator; `None` if they are too long.
    pub fn new(
        wave: Wave,
        harmonics: HarmonicParity,
        denominator: W,
        numerators: &'a [W],
    ) -> Option<Self> {
        let largest = largest(numerators);
        (largest < W::BOUND && denominator > W::zero()).then_some(Self {
            header: Header { wave, harmonics, denominator, largest },
            numerators,
        })
    }

    /// The series zero.
    pub fn zero(wave: Wave, harmonics: HarmonicParity) -> Self {
        Self {
            header: Header { wave, harmonics, denominator: W::one(), largest: 0.0 },
            numerators: &[],
        }
    }

    /// Cosines or sines.
    pub fn wave(self) -> Wave {
        self.header.wave
    }

    /// The common denominator, positive.
    pub fn denominator(self) -> W {
        self.header.denominator
    }

    /// The harmonics that are stored.
    pub fn harmonics(self) -> HarmonicParity {
        self.header.harmonics
    }

    /// The numerators of the harmonics that may occur.
    pub fn numerators(self) -> &'a [W] {
        self.numerators
    }

    /// The numerator at a place, zero beyond the last.
    pub fn numerator(self, index: usize) -> W {
        self.numerators.get(index).copied().unwrap_or(W::zero())
    }

    /// Whether every number is zero.
    pub fn is_zero(self) -> bool {
        self.header.largest == 0.0
    }

    /// The coefficient at a place.
    pub fn coefficient(self, index: usize) -> Option<ShortFraction<W>> {
        ShortFraction::new(self.numerator(index), self.header.denominator)
    }
}

/// The largest absolute value, rounded.
#[inline]
fn largest<W: FixedWidth>(numerators: &[W]) -> f64 {
    // The extremes by comparisons alone: the least number has no absolute value of its width.
    let (mut least, mut most) = (W::zero(), W::zero());
    for numerator in numerators {
        (least, most) = (least.min(*numerator), most.max(*numerator));
    }
    least.size().max(most.size())
}

/// The result of an operation, in memory that serves one operation after the other.
///
/// An operation that returns `None`, because a number is too long, leaves no series.
#[derive(Clone, Debug)]
pub struct SeriesBuffer<W = i128> {
    header: Header<W>,
    numerators: Vec<W>,
    /// Numbers beside the numerators: those of differences of harmonics, divisors.
    others: Vec<W>,
}

impl<W: FixedWidth> Default for SeriesBuffer<W> {
    fn default() -> Self {
        Self::with_capacity(0)
    }
}

impl<W: FixedWidth> SeriesBuffer<W> {
    /// A series without terms, with room for so many.
    pub fn with_capacity(count: usize) -> Self {
        Self {
            header: ShortSeries::zero(Wave::Cosine, HarmonicParity::All).header,
            numerators: Vec::with_capacity(count),
            others: Vec::with_capacity(2 * count),
        }
    }

    /// The series.
    pub fn series(&self) -> ShortSeries<'_, W> {
        ShortSeries { header: self.header, numerators: &self.numerators }
    }

    /// Sets the header of the numerators; `None` if they are too long.
    fn finish(&mut self, wave: Wave, harmonics: HarmonicParity, denominator: W) -> Option<()> {
        let largest = largest(&self.numerators);
        self.header = Header { wave, harmonics, denominator, largest };
        (largest < W::BOUND && denominator > W::zero()).then_some(())
    }

    /// Sets a copy of a series.
    pub fn set(&mut self, series: ShortSeries<W>) {
        self.numerators.clear();
        self.numerators.extend(series.numerators);
        self.header = series.header;
    }

    /// Changes the numerator at a place; `None` if it is too long.
    pub fn set_numerator(&mut self, index: usize, numerator: W) -> Option<()> {
        if self.numerators.len() <= index {
            self.numerators.resize(index + 1, W::zero());
        }
        self.numerators[index] = numerator;
        let Header { wave, harmonics, denominator, .. } = self.header;
        self.finish(wave, harmonics, denominator)
    }

    /// Reduces the series to lowest terms.
    pub fn reduce(&mut self) {
        // Powers of two are cancelled first; mostly no other common factor is left.
        let all = self.numerators.iter().fold(W::zero(), |all, numerator| all | *numerator);
        let denominator = self.header.denominator;
        let halvings = denominator.trailing_zeros();
        let mut odd = denominator >> halvings as usize;
        for numerator in &self.numerators {
            if odd.is_one() {
                break;
            }
            odd = greatest_common_divisor(odd, *numerator);
        }
        let shift = halvings.min(all.trailing_zeros()) as usize;
        let common = odd << shift;
        if !common.is_one() {
            self.header.denominator = exact_quotient(denominator, common);
            self.header.largest /= common.size();
            for numerator in &mut self.numerators {
                *numerator = *numerator >> shift;
                if !odd.is_one() {
                    *numerator = numerator.quotient(odd);
                }
            }
        }
    }

    /// Multiplies the series by a fraction with a positive denominator, and reduces it to lowest
    /// terms; `None` if it is too long.
    pub fn multiply(&mut self, numerator: W, denominator: W) -> Option<()> {
        let Header { wave, harmonics, denominator: own, largest } = self.header;
        if largest * numerator.size() >= W::BOUND {
            return None;
        }
        for own in &mut self.numerators {
            *own = own.wrapping_mul(&numerator);
        }
        self.finish(wave, harmonics, own.product(denominator)?)?;
        self.reduce();
        Some(())
    }

    /// Sets the derivative of a series; `None` if it is too long.
    pub fn set_derivative(&mut self, series: ShortSeries<W>) -> Option<()> {
        match series.wave() {
            Wave::Cosine => self.set_times_harmonics(series, Wave::Sine, |harmonic| -harmonic),
            Wave::Sine => self.set_times_harmonics(series, Wave::Cosine, |harmonic| harmonic),
        }
    }

    /// Sets the second derivative of a series; `None` if it is too long.
    pub fn set_second_derivative(&mut self, series: ShortSeries<W>) -> Option<()> {
        self.set_times_harmonics(series, series.wave(), |harmonic| -(harmonic * harmonic))
    }

    fn set_times_harmonics(
        &mut self,
        series: ShortSeries<W>,
        wave: Wave,
        factor: impl Fn(W) -> W,
    ) -> Option<()> {
        self.numerators.clear();
        let harmonics = series.harmonics();
        for (index, numerator) in series.numerators.iter().enumerate() {
            let harmonic = self::harmonic(harmonics, index)?;
            self.numerators.push(numerator.product(factor(harmonic))?);
        }
        self.finish(wave, harmonics, series.denominator())
    }

    /// Replaces the series by its derivative; `None` if that is too long.
    pub fn differentiate(&mut self) -> Option<()> {
        let Header { wave, harmonics, denominator, .. } = self.header;
        for (index, numerator) in self.numerators.iter_mut().enumerate() {
            let harmonic = self::harmonic::<W>(harmonics, index)?;
            let factor = if wave == Wave::Cosine { -harmonic } else { harmonic };
            *numerator = numerator.product(factor)?;
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
        let mut common = W::one();
        for (index, numerator) in self.numerators.iter_mut().enumerate() {
            let harmonic = self::harmonic::<W>(harmonics, index)?;
            let divisor = harmonic * harmonic - W::one();
            if divisor.is_zero() || numerator.is_zero() {
                *numerator = W::zero();
                self.others.push(W::one());
                continue;
            }
            // The divisor of the zeroth harmonic is minus one, hence the absolute value.
            let shared = greatest_common_divisor(divisor.abs(), *numerator);
            let left = exact_quotient(divisor.abs(), shared);
            *numerator = exact_quotient(*numerator, shared) * -divisor.signum();
            self.others.push(left);
            common = least_common_multiple(common, left)?;
        }
        if largest * common.size() >= W::BOUND {
            return None;
        }
        if !common.is_one() {
            for (numerator, left) in self.numerators.iter_mut().zip(&self.others) {
                *numerator = numerator.wrapping_mul(&exact_quotient(common, *left));
            }
        }
        self.finish(wave, harmonics, denominator.product(common)?)
    }

    /// Sets `sum of (numerator / denominator) series`; all series must have the same kind of waves.
    /// `None` if it is too long or there are no terms.
    pub fn set_combination(&mut self, terms: &[(W, W, ShortSeries<W>)]) -> Option<()> {
        let mut common = W::one();
        let mut length = 0;
        let first = terms.first()?.2;
        for (_, denominator, series) in terms {
            common = least_common_multiple(common, denominator.product(series.denominator())?)?;
            length = length.max(series.numerators.len());
        }
        let mut bound = 0.0;
        self.numerators.clear();
        self.numerators.resize(length, W::zero());
        for (numerator, denominator, series) in terms {
            let own = denominator.wrapping_mul(&series.denominator());
            let factor = numerator.product(exact_quotient(common, own))?;
            let factor_bound = factor.bound();
            bound += factor_bound * series.header.largest;
            if bound >= W::BOUND {
                return None;
            }
            let pairs = self.numerators.iter_mut().zip(series.numerators);
            match !W::IS_WIDE || factor_bound.max(series.header.largest) < WORD {
                true => pairs.for_each(|(sum, own)| {
                    *sum = sum.wrapping_add(&factor.product_of_words(*own));
                }),
                false => {
                    pairs.for_each(|(sum, own)| *sum = sum.wrapping_add(&factor.wrapping_mul(own)))
                }
            }
        }
        self.finish(first.wave(), first.harmonics(), common)
    }

    /// Sets `sum of left_i right_(last - i)` over `first <= i <= last`; all products must have the
    /// same kind of waves. `None` if it is too long, or there are not so many series.
    pub fn set_convolution(
        &mut self,
        left: &ShortSeriesList<W>,
        right: &ShortSeriesList<W>,
        first: usize,
        last: usize,
    ) -> Option<()> {
        if last >= left.len() || last.checked_sub(first)? >= right.len() {
            return None;
        }
        let weight = |_| W::one();
        self.set_sum_of_products(
            first..last + 1,
            weight,
            |i| left.known(i),
            |i| right.known(last - i),
        )
    }

    /// Sets `sum of series_i series_(last - i)`, each pair once; `None` as for a
    /// [convolution](Self::set_convolution).
    pub fn set_square(&mut self, series: &ShortSeriesList<W>, last: usize) -> Option<()> {
        if last >= series.len() {
            return None;
        }
        let weight = |i: usize| if 2 * i == last { W::one() } else { twice(W::one()) };
        let (left, right) = (|i| series.known(i), |i| series.known(last - i));
        self.set_sum_of_products(0..last / 2 + 1, weight, left, right)
    }

    /// Sets a product; `None` if it is too long.
    pub fn set_product(&mut self, left: ShortSeries<W>, right: ShortSeries<W>) -> Option<()> {
        self.set_sum_of_products(0..1, |_| W::one(), |_| left, |_| right)
    }

    /// Sets `sum of weight left right` over some terms; all products must have the same kind of
    /// waves.
    fn set_sum_of_products<'a>(
        &mut self,
        range: Range<usize>,
        weight: impl Fn(usize) -> W,
        left: impl Fn(usize) -> ShortSeries<'a, W>,
        right: impl Fn(usize) -> ShortSeries<'a, W>,
    ) -> Option<()>
    where
        W: 'a,
    {
        let mut common = W::one();
        let mut length = 1;
        let mut kind = (Wave::Cosine, HarmonicParity::Even);
        for index in range.clone() {
            let (left, right) = (left(index), right(index));
            let own = left.denominator().product(right.denominator())?;
            common = least_common_multiple(common, own)?;
            length = length.max(left.numerators.len() + right.numerators.len());
            let wave = if left.wave() == right.wave() { Wave::Cosine } else { Wave::Sine };
            kind = (wave, left.harmonics().times(right.harmonics()));
        }
        let mut bound = 0.0;
        // The harmonics' sums and, apart, their differences, from minus the length on.
        let Self { numerators: sums, others: differences, .. } = self;
        for (list, length) in [(&mut *sums, length), (&mut *differences, 2 * length)] {
            list.clear();
            list.resize(length, W::zero());
        }
        for index in range {
            let (left, right) = (left(index), right(index));
            let own = left.denominator().wrapping_mul(&right.denominator());
            let factor = weight(index).product(exact_quotient(common, own))?;
            let (short, long) = match left.numerators.len() <= right.numerators.len() {
                true => (&left, &right),
                false => (&right, &left),
            };
            let largest = factor.bound() * short.header.largest;
            // Every harmonic of the result gets at most one term from sums of harmonics and two from
            // differences per coefficient of the shorter factor.
            bound += largest * long.header.largest * (3 * short.numerators.len()) as f64;
            if bound >= W::BOUND {
                return None;
            }
            let (into, pair) = ((&mut sums[..], &mut differences[..]), (short, long));
            // If a factor fits one word, its products take a third of the instructions, or one.
            let fits = |largest: f64| !W::IS_WIDE || largest < WORD;
            match (fits(largest), fits(long.header.largest)) {
                (true, true) => add_doubled_product(into, factor, pair, W::product_of_words),
                (true, false) => add_doubled_product(into, factor, pair, W::word_times),
                (false, true) => add_doubled_product(into, factor, pair, times_word),
                _ => add_doubled_product(into, factor, pair, |own, other| own.wrapping_mul(&other)),
            }
        }
        // The harmonics of negative differences: -1, -2, ... or, where only odd ones occur, -1, -3, ...
        let (below, above) = differences.split_at(length);
        let first = usize::from(kind.1 != HarmonicParity::Odd);
        sums[..first].iter_mut().zip(above).for_each(|(sum, own)| *sum = sum.wrapping_add(own));
        let both = above[first..].iter().zip(below.iter().rev());
        for (sum, (above, below)) in sums[first..].iter_mut().zip(both) {
            let differences = match kind.0 {
                Wave::Cosine => above.wrapping_add(below),
                Wave::Sine => above.wrapping_sub(below),
            };
            *sum = sum.wrapping_add(&differences);
        }
        if kind.0 == Wave::Sine && kind.1 != HarmonicParity::Odd {
            sums[0] = W::zero();
        }
        let last = sums.iter().rposition(|sum| !sum.is_zero()).unwrap_or(0);
        sums.truncate(last + 1);
        self.finish(kind.0, kind.1, common.product(twice(W::one()))?)
    }
}

/// The harmonic at a place as a factor; `None` if its square does not fit.
#[inline]
fn harmonic<W: FixedWidth>(harmonics: HarmonicParity, index: usize) -> Option<W> {
    cast(u32::try_from(harmonics.harmonic(index)).ok().filter(|harmonic| *harmonic < 1 << 31)?)
}

/// The product of any number and one that fits one word.
#[inline]
fn times_word<W: FixedWidth>(left: W, right: W) -> W {
    right.word_times(left)
}

/// Adds twice a product by `2 cos i cos j = cos(j+i) + cos(j-i)` and the similar formulas with
/// sines, the sums of harmonics and their differences apart, with the difference zero, or one where
/// only odd ones occur, in the middle; fast if the longer factor is the second.
fn add_doubled_product<W: FixedWidth>(
    (sums, differences): (&mut [W], &mut [W]),
    factor: W,
    (short, long): (&ShortSeries<W>, &ShortSeries<W>),
    multiply: impl Fn(W, W) -> W + Copy,
) {
    use HarmonicParity::{Even, Odd};
    let (first, middle) = match (short.harmonics(), long.harmonics()) {
        (Odd, Odd) => (1, differences.len() / 2),
        (Odd, Even) => (0, differences.len() / 2 - 1),
        _ => (0, differences.len() / 2),
    };
    let [short_is_sine, long_is_sine] = [short, long].map(|series| series.wave() == Wave::Sine);
    for (place, own) in short.numerators.iter().enumerate() {
        let own = own.wrapping_mul(&factor);
        if own.is_zero() {
            continue;
        }
        let sums = sums[first + place..].iter_mut();
        let differences = differences[middle - place..].iter_mut();
        let all = sums.zip(differences).zip(long.numerators);
        // 2 sin i sin j = -cos(j+i) + cos(j-i),   2 sin i cos j = sin(j+i) - sin(j-i)
        match short_is_sine {
            false => all.for_each(|((sum, difference), other)| {
                let product = multiply(own, *other);
                *sum = sum.wrapping_add(&product);
                *difference = difference.wrapping_add(&product);
            }),
            true => {
                let own = if long_is_sine { own.wrapping_neg() } else { own };
                all.for_each(|((sum, difference), other)| {
                    let product = multiply(own, *other);
                    *sum = sum.wrapping_add(&product);
                    *difference = difference.wrapping_sub(&product);
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fourier::{self, FourierSeries};
    use super::*;
    use crate::exact::{Integer, Integers};

    /// The series with integers of any length.
    fn long<W: FixedWidth>(series: ShortSeries<W>) -> FourierSeries<Integers> {
        let mut coefficients = vec![];
        for (index, numerator) in series.numerators().iter().enumerate() {
            coefficients.resize(series.harmonics().harmonic(index), Integer::from(0));
            coefficients.push((*numerator).into());
        }
        let (cosine, sine) = match series.wave() {
            Wave::Cosine => (coefficients, vec![]),
            Wave::Sine => (vec![], coefficients),
        };
        FourierSeries::from_parts(Integers, cosine, sine).over(&series.denominator().into())
    }

    /// The result of an operation.
    fn found<W: FixedWidth>(
        operation: impl Fn(&mut SeriesBuffer<W>) -> Option<()>,
    ) -> FourierSeries<Integers> {
        let mut buffer = SeriesBuffer::default();
        // The buffer is not empty, as it is not in use.
        buffer.set_numerator(20, small(17)).expect("short");
        operation(&mut buffer).expect("short");
        long(buffer.series())
    }

    fn small<W: FixedWidth>(number: i64) -> W {
        cast(number).expect("a small number")
    }

    fn list<W: FixedWidth>(series: &[ShortSeries<W>]) -> ShortSeriesList<W> {
        let mut list = ShortSeriesList::default();
        series.iter().for_each(|series| list.push(*series));
        list
    }

    /// Series of both waves and all kinds of harmonics, with numerators that are not multiples of
    /// each other.
    fn examples<W: FixedWidth>() -> ShortSeriesList<W> {
        let mut examples = ShortSeriesList::default();
        for wave in [Wave::Cosine, Wave::Sine] {
            for harmonics in [HarmonicParity::All, HarmonicParity::Even, HarmonicParity::Odd] {
                for (length, denominator) in [(1, 3), (4, 32), (7, 90)] {
                    let mut numerators: Vec<W> =
                        (0..length).map(|k| small(k * k * k - 9 * k + 5)).collect();
                    if wave == Wave::Sine && harmonics != HarmonicParity::Odd {
                        numerators[0] = W::zero();
                    }
                    let series = ShortSeries::new(wave, harmonics, small(denominator), &numerators);
                    examples.push(series.expect("short"));
                }
            }
        }
        examples
    }

    #[test]
    fn short_series_are_those_of_any_length() {
        agree::<i64>();
        agree::<i128>();
    }

    fn agree<W: FixedWidth>() {
        let mut products = 0;
        let examples = examples::<W>();
        let all = || (0..examples.len()).map(|index| examples.get(index).expect("an example"));
        for left in all() {
            let changed = |change: fn(&mut SeriesBuffer<W>) -> Option<()>| {
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
                let sum = found(|buffer| {
                    buffer.set_sum_of_products(0..1, |_| small(3), |_| left, |_| right)
                });
                let expected = fourier::sum_of_products(&Integers, &[(3, &long_left, &long_right)]);
                assert_eq!(sum, expected, "{left:?} {right:?}");
                let product = found(|buffer| buffer.set_product(left, right));
                assert_eq!(product, long_left.product(&long_right));
                let (forth, back) = (list(&[left, right]), list(&[right, left]));
                let twice = fourier::sum_of_products(&Integers, &[(2, &long_left, &long_right)]);
                let convolution = |other: &ShortSeriesList<W>, first| {
                    found(|buffer| buffer.set_convolution(&forth, other, first, 1))
                };
                assert_eq!(convolution(&forth, 0), twice);
                assert_eq!(convolution(&forth, 1), long_right.product(&long_left));
                assert_eq!(found(|buffer| buffer.set_square(&forth, 1)), twice);
                if (left.wave(), left.harmonics()) == (right.wave(), right.harmonics()) {
                    let squares = [(1, &long_left, &long_left), (1, &long_right, &long_right)];
                    let expected = fourier::sum_of_products(&Integers, &squares);
                    assert_eq!(convolution(&back, 0), expected);
                    let terms = [(small(2), small(7), left), (small(-5), small(1), right)];
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

//! Values of sums of waves at points, and their coefficients from the values, over residues: a
//! product of series is a product of values.
//!
//! References: K. R. Rao and P. Yip, *Discrete Cosine Transform*, Academic Press 1990, chapter 4;
//! B. G. Lee, *A new algorithm to compute the discrete cosine transform*, IEEE Trans. ASSP 32
//! (1984) 1243-1245, for the halving.
//!
//! ```text
//! phi_k = (2k+1) pi/(2M),  k = 0 .. M-1            V_k = sum_i q_i cos(i phi_k)
//! even i: the same of half the size at 2 phi_k;     odd i: (1/(2 cos phi_k)) sum_i (o_i + o_(i-1)) cos(2 i phi_k)
//! 2 cos(theta) cos((2j+1) theta) = cos((2j+2) theta) + cos(2j theta),   theta = phi/2   (odd harmonics alone)
//! 2 sin(theta) sin((2j+1) theta) = cos(2j theta) - cos((2j+2) theta)
//! 2 sin(phi) sin(m phi) = cos((m-1) phi) - cos((m+1) phi)
//! ```
//!
//! Motions with half-wave symmetry have odd harmonics only and are known by their values on a
//! quarter of the period; the others need half of it. Only pure sums of cosines and pure sums of
//! sines are transformed, not series with both. The inverse transformation is `2/M` times the
//! transpose of the transformation. Cost: `M (leaf + log(M/leaf))` for `M` points, where sums of
//! `leaf` waves are formed directly.

use pulp::NullaryFnOnce;

use crate::exact::residue::sums::multiply;
use crate::exact::residue::{Arithmetic, Lanes, Residues};

/// Number of points below which direct sums are as fast as another halving.
const LEAF: usize = 12;

/// The number and the symmetry of the points, with the structure of their transformation.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Whether there are only odd harmonics, with points on a quarter of the period; otherwise
    /// there are all, with points on half of it.
    half_wave: bool,
    halvings: usize,
    leaf: usize,
}

impl Grid {
    /// The points for `count` harmonics: the odd ones `1, 3, ...` or all of `0, 1, 2, ...`.
    pub fn new(count: usize, half_wave: bool) -> Self {
        let mut halvings = 0;
        while count >> (halvings + 1) >= LEAF {
            halvings += 1;
        }
        Self { half_wave, halvings, leaf: count.max(1).div_ceil(1 << halvings) }
    }

    /// The number of points.
    pub fn size(&self) -> usize {
        self.leaf << self.halvings
    }

    /// Returns the order of the roots of unity that the points and their waves need; every prime
    /// must have them.
    pub fn circle(&self) -> usize {
        let quarters = if self.half_wave { 8 } else { 4 };
        quarters * self.size()
    }

    /// Returns the order of the points, as `k` of `phi_k`: the second half is the mirror image of
    /// the first, at each level.
    fn points(&self) -> Vec<usize> {
        let mut points: Vec<usize> = (0..self.leaf).collect();
        for _ in 0..self.halvings {
            let last = 2 * points.len() - 1;
            let mirrored: Vec<usize> = points.iter().map(|k| last - k).collect();
            points.extend(mirrored);
        }
        points
    }
}

/// Cosines or sines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wave {
    /// `cos`.
    Cosine,
    /// `sin`.
    Sine,
}

impl Wave {
    /// The kind of series of the derivative.
    pub fn other(self) -> Self {
        match self {
            Self::Cosine => Self::Sine,
            Self::Sine => Self::Cosine,
        }
    }
}

/// The waves on a [`Grid`], eight side by side.
pub struct Waves {
    grid: Grid,
    /// The cosines of the multiples of the angle `2 pi/(4 leaf)`.
    cosines: Vec<Lanes>,
    /// The inverse divisors of cosines and of sines at the points, and then the factors
    /// `1/(2 cos phi)` of each halving, the largest first.
    inverses: Vec<Lanes>,
    over_size: Lanes,
    half: Lanes,
    scratch: Vec<Lanes>,
}

impl Waves {
    /// Prepares the transformation; `None` if a prime does not have the roots of unity.
    #[inline(always)]
    pub fn new<A: Arithmetic>(residues: &Residues<A>, grid: Grid) -> Option<Self> {
        let (size, circle) = (grid.size(), grid.circle());
        let root = residues.root_of_unity(circle as u64)?;
        let powers = residues.powers(root, circle);
        let points = grid.points();
        let unit = circle / (4 * size);
        let levels: Vec<usize> = (0..grid.halvings).map(|halving| size >> halving).collect();
        // The angles, in parts of the circle, whose double cosines are divisors.
        let mut angles = Vec::new();
        let thetas = points.iter().map(|k| (2 * k + 1) * unit / if grid.half_wave { 2 } else { 1 });
        angles.extend(thetas.clone());
        angles.extend(thetas.map(|theta| circle + circle / 4 - theta));
        for level in &levels {
            angles
                .extend(points.iter().take(level / 2).map(|k| (2 * k + 1) * circle / (4 * level)));
        }
        let mut inverses = vec![residues.one(); angles.len() + 2];
        for (place, (inverse, angle)) in inverses.iter_mut().zip(&angles).enumerate() {
            // Cosines of all harmonics need no divisor here, and it could be zero.
            if grid.half_wave || place >= size {
                let angle = angle % circle;
                *inverse = residues.sum(powers[angle], powers[(circle - angle) % circle]);
            }
        }
        inverses[angles.len()] = residues.small(2);
        inverses[angles.len() + 1] = residues.small(size);
        residues.invert(&mut inverses)?;
        let half = inverses[angles.len()];
        let mut cosines = vec![half; 4 * grid.leaf];
        let step = circle / cosines.len();
        for (place, cosine) in cosines.iter_mut().enumerate() {
            let twice =
                residues.sum(powers[place * step], powers[(circle - place * step) % circle]);
            *cosine = residues.product(twice, half);
        }
        Some(Self {
            grid,
            cosines,
            over_size: inverses[angles.len() + 1],
            inverses,
            half,
            scratch: vec![Lanes::default(); 2 * size],
        })
    }

    /// The residues of 1/2.
    pub fn half(&self) -> Lanes {
        self.half
    }

    /// Computes the values at all points of the sum of waves with these coefficients.
    #[inline(always)]
    pub fn values<A: Arithmetic>(
        &mut self,
        residues: &Residues<A>,
        wave: Wave,
        coefficients: &[Lanes],
        values: &mut [Lanes],
    ) {
        let work = EvaluateWaves(self, residues, wave, coefficients, values);
        residues.arithmetic.vectorize(work);
    }

    /// Computes the coefficients of the first `out.len()` waves from the values at all points,
    /// which are overwritten.
    #[inline(always)]
    pub fn coefficients<A: Arithmetic>(
        &mut self,
        residues: &Residues<A>,
        wave: Wave,
        values: &mut [Lanes],
        out: &mut [Lanes],
    ) {
        let work = RecoverCoefficients(self, residues, wave, values, out);
        residues.arithmetic.vectorize(work);
    }

    /// Returns the inverse divisors, point by point, that reduce the waves to cosines of multiples
    /// of `phi`; `None` if there are none.
    fn divisors(&self, wave: Wave) -> Option<&[Lanes]> {
        let size = self.grid.size();
        match (self.grid.half_wave, wave) {
            (_, Wave::Sine) => Some(&self.inverses[size..2 * size]),
            (true, Wave::Cosine) => Some(&self.inverses[..size]),
            (false, Wave::Cosine) => None,
        }
    }

    /// Returns the factors of a halving.
    #[inline(always)]
    fn halving(&self, halving: usize) -> &[Lanes] {
        let size = self.grid.size();
        // Those of the halvings before are `size/2 + size/4 + ...`.
        &self.inverses[3 * size - (size >> halving)..][..size >> (halving + 1)]
    }
}

/// Returns two sums of values times cosines; for each the angle of the first cosine and the step to
/// the next are given in parts of the circle.
#[inline(always)]
fn cosine_sums<A: Arithmetic>(
    residues: &Residues<A>,
    cosines: &[Lanes],
    (left, right): (&[Lanes], &[Lanes]),
    [(mut of_left, left_step), (mut of_right, right_step)]: [(usize, usize); 2],
) -> (Lanes, Lanes) {
    const { assert!(LEAF <= A::RUN) };
    let arithmetic = residues.arithmetic;
    let next = |angle: usize, step: usize| {
        let angle = angle + step;
        if angle >= cosines.len() { angle - cosines.len() } else { angle }
    };
    let (mut of_left_sum, mut of_right_sum) = (arithmetic.none(), arithmetic.none());
    for (left, right) in left.iter().zip(right) {
        of_left_sum = arithmetic.add_product(of_left_sum, left, &cosines[of_left]);
        of_right_sum = arithmetic.add_product(of_right_sum, right, &cosines[of_right]);
        (of_left, of_right) = (next(of_left, left_step), next(of_right, right_step));
    }
    // The left list may have one more entry.
    for left in &left[right.len().min(left.len())..] {
        of_left_sum = arithmetic.add_product(of_left_sum, left, &cosines[of_left]);
    }
    (residues.reduce(of_left_sum), residues.reduce(of_right_sum))
}

struct EvaluateWaves<'a, A>(&'a mut Waves, &'a Residues<A>, Wave, &'a [Lanes], &'a mut [Lanes]);

impl<A: Arithmetic> NullaryFnOnce for EvaluateWaves<'_, A> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(waves, residues, wave, given, values) = self;
        let Grid { half_wave, halvings, leaf } = waves.grid;
        let size = waves.grid.size();
        let mut scratch = std::mem::take(&mut waves.scratch);
        let (cosines, rest) = scratch.split_at_mut(size);
        // The waves are converted to cosines of multiples of phi; the cosine of index `size` is
        // zero at all points.
        let length = (given.len() + 1).min(size);
        let (own, more) = cosines.split_at_mut(given.len().min(size));
        own.copy_from_slice(&given[..own.len()]);
        more.fill(Lanes::default());
        match (half_wave, wave) {
            (true, Wave::Cosine) => {
                for (cosine, below) in cosines[1..length].iter_mut().zip(given) {
                    *cosine = residues.sum(*cosine, *below);
                }
            }
            (true, Wave::Sine) => {
                for (cosine, below) in cosines[1..length].iter_mut().zip(given) {
                    *cosine = residues.difference(*cosine, *below);
                }
            }
            (false, Wave::Cosine) => {}
            // There is no sine of index zero.
            (false, Wave::Sine) => {
                for i in 0..length {
                    let above = given.get(i + 1).copied().unwrap_or_default();
                    let below = if i > 1 { given[i - 1] } else { Lanes::default() };
                    cosines[i] = residues.difference(above, below);
                }
            }
        }
        for halving in 0..halvings {
            let level = size >> halving;
            for part in cosines.chunks_exact_mut(level) {
                let whole = &mut rest[..level];
                whole.copy_from_slice(part);
                let (even, odd) = part.split_at_mut(level / 2);
                let mut before = Lanes::default();
                for ((pair, even), odd) in whole.chunks_exact(2).zip(even).zip(odd) {
                    *even = pair[0];
                    *odd = residues.sum(before, pair[1]);
                    before = pair[1];
                }
            }
        }
        // Each halving adds one wave.
        let used = ((length >> halvings) + 3).min(leaf);
        let (even, odd) = rest[..leaf].split_at_mut(leaf.div_ceil(2));
        let (even, odd) = (&mut even[..used.div_ceil(2)], &mut odd[..used / 2]);
        for (part, values) in cosines.chunks_exact(leaf).zip(values.chunks_exact_mut(leaf)) {
            for (place, own) in part[..used].iter().enumerate() {
                let half = if place % 2 == 0 { &mut *even } else { &mut *odd };
                half[place / 2] = *own;
            }
            // At the mirror image of a point the odd cosines have the opposite sign.
            for k in 0..leaf.div_ceil(2) {
                let step = 2 * k + 1;
                let (even, odd) = cosine_sums(
                    residues,
                    &waves.cosines,
                    (even, odd),
                    [(0, 2 * step), (step, 2 * step)],
                );
                values[leaf - 1 - k] = residues.difference(even, odd);
                values[k] = residues.sum(even, odd);
            }
        }
        for halving in (0..halvings).rev() {
            let level = size >> halving;
            for part in values.chunks_exact_mut(level) {
                let (even, odd) = part.split_at_mut(level / 2);
                for ((even, odd), over) in even.iter_mut().zip(odd).zip(waves.halving(halving)) {
                    let value = residues.product(*odd, *over);
                    (*even, *odd) = (residues.sum(*even, value), residues.difference(*even, value));
                }
            }
        }
        if let Some(over) = waves.divisors(wave) {
            multiply(residues, values, over);
        }
        waves.scratch = scratch;
    }
}

struct RecoverCoefficients<'a, A>(
    &'a mut Waves,
    &'a Residues<A>,
    Wave,
    &'a mut [Lanes],
    &'a mut [Lanes],
);

impl<A: Arithmetic> NullaryFnOnce for RecoverCoefficients<'_, A> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(waves, residues, wave, values, out) = self;
        let Grid { half_wave, halvings, leaf } = waves.grid;
        let size = waves.grid.size();
        let mut scratch = std::mem::take(&mut waves.scratch);
        if let Some(over) = waves.divisors(wave) {
            multiply(residues, values, over);
        }
        for halving in 0..halvings {
            let level = size >> halving;
            for part in values.chunks_exact_mut(level) {
                let (sums, odd) = part.split_at_mut(level / 2);
                for ((sum, odd), over) in sums.iter_mut().zip(odd).zip(waves.halving(halving)) {
                    let difference = residues.difference(*sum, *odd);
                    (*sum, *odd) = (residues.sum(*sum, *odd), residues.product(difference, *over));
                }
            }
        }
        let used = ((out.len() >> halvings) + 4).min(leaf);
        let (sums, differences) = scratch[..2 * leaf].split_at_mut(leaf);
        let half = leaf.div_ceil(2);
        let (sums, differences) = (&mut sums[..half], &mut differences[..half]);
        for part in values.chunks_exact_mut(leaf) {
            for k in 0..half {
                let mirrored = part[leaf - 1 - k];
                sums[k] = if 2 * k + 1 == leaf { part[k] } else { residues.sum(part[k], mirrored) };
                differences[k] = residues.difference(part[k], mirrored);
            }
            part.fill(Lanes::default());
            for i in (0..used).step_by(2) {
                let angles = [(i, 2 * i), (i + 1, 2 * i + 2)];
                let (even, odd) =
                    cosine_sums(residues, &waves.cosines, (sums, differences), angles);
                part[i] = even;
                if let Some(next) = part[..used].get_mut(i + 1) {
                    *next = odd;
                }
            }
        }
        for halving in (0..halvings).rev() {
            let level = size >> halving;
            for part in values.chunks_exact_mut(level) {
                let halves = &mut scratch[..level];
                halves.copy_from_slice(part);
                let (even, odd) = halves.split_at(level / 2);
                for (place, pair) in part.chunks_exact_mut(2).enumerate() {
                    let next = odd.get(place + 1).copied().unwrap_or_default();
                    (pair[0], pair[1]) = (even[place], residues.sum(odd[place], next));
                }
            }
        }
        let weight = residues.sum(waves.over_size, waves.over_size);
        let zero = Lanes::default();
        for (j, coefficient) in out.iter_mut().enumerate() {
            let own = values.get(j).copied().unwrap_or_default();
            let next = values.get(j + 1).copied().unwrap_or_default();
            let sum = match (half_wave, wave) {
                (true, Wave::Cosine) => residues.sum(own, next),
                (true, Wave::Sine) => residues.difference(own, next),
                (false, Wave::Cosine) => own,
                (false, Wave::Sine) if j == 0 => zero,
                (false, Wave::Sine) => {
                    let before = values.get(j - 1).copied().unwrap_or_default();
                    residues.difference(before, next)
                }
            };
            let mean = (half_wave, wave, j) == (false, Wave::Cosine, 0);
            *coefficient = residues.product(sum, if mean { waves.over_size } else { weight });
        }
        waves.scratch = scratch;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::residue::{
        Moduli, Modulus, WIDTH, Work, by_widest, portable::Portable, primes_below,
    };

    /// Products of sums of waves by values, against the formulas for products of two waves.
    struct Products {
        count: usize,
        half_wave: bool,
    }

    impl Products {
        fn harmonic(&self, index: usize) -> usize {
            if self.half_wave { 2 * index + 1 } else { index }
        }
    }

    impl Work for Products {
        type Output = ();

        fn run<A: Arithmetic>(self, arithmetic: A) {
            let grid = Grid::new(3 * self.count, self.half_wave);
            let moduli: Vec<Modulus> = primes_below(A::BITS, grid.circle() as u64)
                .take(WIDTH)
                .map(|prime| Modulus::new(prime, A::RADIX))
                .collect();
            let residues = &Residues { arithmetic, moduli: Moduli::from_primes(&moduli) };
            let mut waves = Waves::new(residues, grid).expect("roots of unity");
            let values = |waves: &mut Waves, wave, coefficients: &[Lanes]| {
                let mut values = vec![Lanes::default(); grid.size()];
                waves.values(residues, wave, coefficients, &mut values);
                values
            };
            let given: Vec<Lanes> = (0..self.count)
                .map(|k| residues.difference(residues.small(k * k + 3), residues.small(7 * k)))
                .collect();
            for wave in [Wave::Cosine, Wave::Sine] {
                // Once there and back.
                let mut own = values(&mut waves, wave, &given);
                let mut back = vec![Lanes::default(); self.count + 1];
                let square: Vec<Lanes> =
                    own.iter().map(|value| residues.product(*value, *value)).collect();
                let second = values(&mut waves, Wave::Cosine, &[Lanes::default(), residues.one()]);
                waves.coefficients(residues, wave, &mut own, &mut back);
                let mut expected = given.clone();
                if wave == Wave::Sine && !self.half_wave {
                    expected[0] = Lanes::default();
                }
                assert_eq!(back[..self.count], expected);
                assert_eq!(back[self.count], Lanes::default());
                // The square times the second cosine: u^2 cos = sum of cosines with harmonics i +
                // j + k and their differences.
                let mut product: Vec<Lanes> =
                    square.iter().zip(second).map(|(u, v)| residues.product(*u, v)).collect();
                let mut found = vec![Lanes::default(); 2 * self.count + 1];
                waves.coefficients(residues, Wave::Cosine, &mut product, &mut found);
                let quarter = residues.inverse(residues.small(4));
                let mut sums = vec![Lanes::default(); found.len()];
                let cosine = self.harmonic(1) as i64;
                for (i, left) in expected.iter().enumerate() {
                    for (j, right) in expected.iter().enumerate() {
                        let (m, n) = (self.harmonic(i) as i64, self.harmonic(j) as i64);
                        let term = residues.product(residues.product(*left, *right), quarter);
                        let upper = if wave == Wave::Sine { residues.negative(term) } else { term };
                        for (harmonic, term) in [(m + n, upper), (m - n, term)] {
                            for harmonic in [harmonic + cosine, harmonic - cosine] {
                                let index = harmonic.unsigned_abs() as usize
                                    / if self.half_wave { 2 } else { 1 };
                                if let Some(sum) = sums.get_mut(index) {
                                    *sum = residues.sum(*sum, term);
                                }
                            }
                        }
                    }
                }
                assert_eq!(found, sums, "{wave:?} {}", self.count);
            }
        }
    }

    #[test]
    fn products_of_values_are_values_of_products() {
        for count in [2, 3, 8, 15, 40] {
            for half_wave in [true, false] {
                Products { count, half_wave }.run(Portable);
                by_widest(Products { count, half_wave });
            }
        }
    }
}

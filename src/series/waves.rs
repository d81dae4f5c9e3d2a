//! Sums of waves at points, and back, over residues: products of series are products of values.
//!
//! References: K. R. Rao and P. Yip, *Discrete Cosine Transform*, Academic Press 1990, chapter 4; B. G. Lee, *A new algorithm to
//! compute the discrete cosine transform*, IEEE Trans. ASSP 32 (1984) 1243-1245, for the halving.
//!
//! ```text
//! phi_k = (2k+1) pi/(2M),  k = 0 .. M-1            V_k = sum_i q_i cos(i phi_k)
//! even i: the same of half the size at 2 phi_k;     odd i: (1/(2 cos phi_k)) sum_i (o_i + o_(i-1)) cos(2 i phi_k)
//! 2 cos(theta) cos((2j+1) theta) = cos((2j+2) theta) + cos(2j theta),   theta = phi/2   (odd harmonics alone)
//! 2 sin(theta) sin((2j+1) theta) = cos(2j theta) - cos((2j+2) theta)
//! 2 sin(phi) sin(m phi) = cos((m-1) phi) - cos((m+1) phi)
//! ```
//!
//! Motions with half-wave symmetry have odd harmonics only and are known by their values on a quarter of the period; the others
//! need half of it. Cosines alone and sines alone are transformed; a series in which both stand has no use for this file. The way
//! back is the transposed of the way there, times `2/M`. Cost: `M (leaf + log(M/leaf))` for `M` points, where the sums of `leaf`
//! waves are formed one by one.

use pulp::NullaryFnOnce;

use crate::exact::residue::sums::{combine_here, multiply_here};
use crate::exact::residue::{Arithmetic, Modulus, Rows, padded};

/// How many points there are, and how they are come by.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Odd harmonics alone, at points on a quarter of the period; otherwise all, on half of it.
    half_wave: bool,
    halvings: usize,
    leaf: usize,
}

impl Grid {
    /// For `count` harmonics: the odd ones `1, 3, ...` or all of `0, 1, 2, ...`.
    pub fn new(count: usize, half_wave: bool) -> Self {
        /// Below, the sums are as fast as another halving.
        const LEAF: usize = 20;
        let mut halvings = 0;
        while count >> (halvings + 1) >= LEAF {
            halvings += 1;
        }
        Self {
            half_wave,
            halvings,
            leaf: count.max(1).div_ceil(1 << halvings),
        }
    }

    /// The number of points.
    pub fn size(&self) -> usize {
        self.leaf << self.halvings
    }

    /// The points and their waves are roots of unity of this order, which a prime has to have.
    pub fn circle(&self) -> usize {
        let quarters = if self.half_wave { 8 } else { 4 };
        quarters * self.size()
    }

    /// The order in which the points stand, as `k` of `phi_k`: of each half, the other is the mirror image.
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
    /// What the derivative consists of.
    pub fn other(self) -> Self {
        match self {
            Self::Cosine => Self::Sine,
            Self::Sine => Self::Cosine,
        }
    }
}

/// The waves on a [`Grid`] modulo one prime.
pub struct Waves {
    grid: Grid,
    /// The waves of the smallest size at their points: an entry for each wave, and for each point.
    forward: Rows,
    backward: Rows,
    /// `1/(2 cos phi)` of each halving, the largest first.
    halving: Vec<Vec<u64>>,
    over_cosine: Vec<u64>,
    over_sine: Vec<u64>,
    over_size: u64,
    scratch: Vec<u64>,
}

impl Waves {
    /// `None` where the prime has no such roots of unity.
    pub fn new(modulus: &Modulus, grid: Grid) -> Option<Self> {
        let (size, circle) = (grid.size(), grid.circle());
        let root = modulus.root_of_unity(circle as u64)?;
        let powers = modulus.powers(root, circle);
        // Twice the cosine of an angle in parts of the circle.
        let twice_cosine =
            |angle: usize| modulus.sum(powers[angle % circle], powers[(circle - angle % circle) % circle]);
        let points = grid.points();
        let unit = circle / (4 * size);
        let theta = |k: &usize| (2 * k + 1) * unit / if grid.half_wave { 2 } else { 1 };
        // Cosines of all harmonics need no such divisor, and it may be zero.
        let divisor = |k: &usize| {
            if grid.half_wave {
                twice_cosine(theta(k))
            } else {
                modulus.one
            }
        };
        let mut inverses: Vec<u64> = points.iter().map(divisor).collect();
        inverses.extend(points.iter().map(|k| twice_cosine(circle + circle / 4 - theta(k))));
        let levels: Vec<usize> = (0..grid.halvings).map(|halving| size >> halving).collect();
        for level in &levels {
            let angle = |k: &usize| (2 * k + 1) * circle / (4 * level);
            inverses.extend(points.iter().take(level / 2).map(|k| twice_cosine(angle(k))));
        }
        inverses.extend([modulus.small(2), modulus.small(size as i64)]);
        modulus.invert(&mut inverses)?;
        let mut inverses = inverses.into_iter();
        let mut take = |count: usize| {
            let mut taken: Vec<u64> = inverses.by_ref().take(count).collect();
            taken.resize(padded(count), 0);
            taken
        };
        let (over_cosine, over_sine) = (take(size), take(size));
        let halving = levels.iter().map(|level| take(level / 2)).collect();
        let (half, over_size) = (take(1)[0], take(1)[0]);
        let leaf = grid.leaf;
        let (mut forward, mut backward) = (Rows::new(leaf, leaf), Rows::new(leaf, leaf));
        let step = circle / (4 * leaf);
        let cosines: Vec<u64> = (0..4 * leaf)
            .map(|angle| modulus.product(twice_cosine(angle * step), half))
            .collect();
        for k in 0..leaf {
            let mut angle = 0;
            for i in 0..leaf {
                forward.set(k, i, cosines[angle]);
                backward.set(i, k, cosines[angle]);
                angle += 2 * k + 1;
                if angle >= 4 * leaf {
                    angle -= 4 * leaf;
                }
            }
        }
        Some(Self {
            grid,
            forward,
            backward,
            halving,
            over_cosine,
            over_sine,
            over_size,
            scratch: vec![0; 2 * (padded(size) + padded(leaf))],
        })
    }

    /// The values at all points of the sum of waves with these coefficients; `values` are as many as the points, [padded].
    pub fn values<A: Arithmetic>(
        &mut self,
        (arithmetic, modulus): (A, &Modulus),
        wave: Wave,
        coefficients: &[u64],
        values: &mut [u64],
    ) {
        arithmetic.vectorize(Values(self, arithmetic, modulus, wave, coefficients, values));
    }

    /// The coefficients of the first `out.len()` waves from the values at all points, which are used up.
    pub fn coefficients<A: Arithmetic>(
        &mut self,
        (arithmetic, modulus): (A, &Modulus),
        wave: Wave,
        values: &mut [u64],
        out: &mut [u64],
    ) {
        arithmetic.vectorize(Coefficients(self, arithmetic, modulus, wave, values, out));
    }

    /// What is divided by, point by point, so that cosines of multiples of `phi` remain.
    fn over(&self, wave: Wave) -> Option<&[u64]> {
        match (self.grid.half_wave, wave) {
            (_, Wave::Sine) => Some(&self.over_sine),
            (true, Wave::Cosine) => Some(&self.over_cosine),
            (false, Wave::Cosine) => None,
        }
    }
}

struct Values<'a, A>(&'a mut Waves, A, &'a Modulus, Wave, &'a [u64], &'a mut [u64]);

impl<A: Arithmetic> NullaryFnOnce for Values<'_, A> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(waves, arithmetic, modulus, wave, given, values) = self;
        let Grid {
            half_wave,
            halvings,
            leaf,
        } = waves.grid;
        let size = waves.grid.size();
        let mut scratch = std::mem::take(&mut waves.scratch);
        let (cosines, rest) = scratch.split_at_mut(padded(size));
        // In cosines of multiples of phi. The one at index `size` is zero at all points.
        let length = (given.len() + 1).min(size);
        let (own, more) = cosines.split_at_mut(given.len().min(size));
        own.copy_from_slice(&given[..own.len()]);
        more.fill(0);
        match (half_wave, wave) {
            (true, Wave::Cosine) => {
                for (cosine, below) in cosines[1..length].iter_mut().zip(given) {
                    *cosine = modulus.sum(*cosine, *below);
                }
            }
            (true, Wave::Sine) => {
                for (cosine, below) in cosines[1..length].iter_mut().zip(given) {
                    *cosine = modulus.difference(*cosine, *below);
                }
            }
            (false, Wave::Cosine) => {}
            // There is no sine of index zero.
            (false, Wave::Sine) => {
                let at = |index: usize| given.get(index).copied().unwrap_or(0);
                for (i, cosine) in cosines[..length].iter_mut().enumerate() {
                    *cosine = modulus.difference(at(i + 1), if i > 1 { at(i - 1) } else { 0 });
                }
            }
        }
        let (rest, small) = rest.split_at_mut(padded(size));
        for halving in 0..halvings {
            let level = size >> halving;
            for part in cosines[..size].chunks_exact_mut(level) {
                let whole = &mut rest[..level];
                whole.copy_from_slice(part);
                let (even, odd) = part.split_at_mut(level / 2);
                for ((pair, even), odd) in whole.chunks_exact(2).zip(even).zip(&mut *odd) {
                    (*even, *odd) = (pair[0], pair[1]);
                }
                for (pair, odd) in whole.chunks_exact(2).zip(&mut odd[1..]) {
                    *odd = modulus.sum(*odd, pair[1]);
                }
            }
        }
        // Each halving brings one more wave.
        let used = ((length >> halvings) + 3).min(leaf);
        let small = &mut small[..padded(leaf)];
        for (part, values) in cosines[..size].chunks_exact(leaf).zip(values.chunks_exact_mut(leaf)) {
            combine_here(arithmetic, modulus, &part[..used], &waves.forward, small);
            values.copy_from_slice(&small[..leaf]);
        }
        for halving in (0..halvings).rev() {
            let level = size >> halving;
            let odd_values = &mut rest[..padded(level / 2)];
            for part in values[..size].chunks_exact_mut(level) {
                let (even, odd) = part.split_at_mut(level / 2);
                odd_values[..level / 2].copy_from_slice(odd);
                multiply_here(arithmetic, modulus, odd_values, &waves.halving[halving]);
                for ((even, odd), value) in even.iter_mut().zip(odd).zip(&*odd_values) {
                    (*even, *odd) = (modulus.sum(*even, *value), modulus.difference(*even, *value));
                }
            }
        }
        if let Some(over) = waves.over(wave) {
            multiply_here(arithmetic, modulus, values, over);
        }
        waves.scratch = scratch;
    }
}

struct Coefficients<'a, A>(&'a mut Waves, A, &'a Modulus, Wave, &'a mut [u64], &'a mut [u64]);

impl<A: Arithmetic> NullaryFnOnce for Coefficients<'_, A> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(waves, arithmetic, modulus, wave, values, out) = self;
        let Grid {
            half_wave,
            halvings,
            leaf,
        } = waves.grid;
        let size = waves.grid.size();
        let mut scratch = std::mem::take(&mut waves.scratch);
        let (rest, small) = scratch.split_at_mut(padded(size));
        let small = &mut small[..padded(leaf)];
        if let Some(over) = waves.over(wave) {
            multiply_here(arithmetic, modulus, values, over);
        }
        for halving in 0..halvings {
            let level = size >> halving;
            let differences = &mut rest[..padded(level / 2)];
            for part in values[..size].chunks_exact_mut(level) {
                let (sums, odd) = part.split_at_mut(level / 2);
                for ((sum, other), difference) in sums.iter_mut().zip(&*odd).zip(&mut *differences) {
                    (*sum, *difference) = (modulus.sum(*sum, *other), modulus.difference(*sum, *other));
                }
                multiply_here(arithmetic, modulus, differences, &waves.halving[halving]);
                odd.copy_from_slice(&differences[..level / 2]);
            }
        }
        let used = padded((out.len() >> halvings) + 4).min(padded(leaf));
        small.fill(0);
        for part in values[..size].chunks_exact_mut(leaf) {
            combine_here(arithmetic, modulus, part, &waves.backward, &mut small[..used]);
            part.copy_from_slice(&small[..leaf]);
        }
        for halving in (0..halvings).rev() {
            let level = size >> halving;
            for part in values[..size].chunks_exact_mut(level) {
                let halves = &mut rest[..level];
                halves.copy_from_slice(part);
                let (even, odd) = halves.split_at(level / 2);
                for ((pair, even), odd) in part.chunks_exact_mut(2).zip(even).zip(odd) {
                    (pair[0], pair[1]) = (*even, *odd);
                }
                for (pair, next) in part.chunks_exact_mut(2).zip(&odd[1..]) {
                    pair[1] = modulus.sum(pair[1], *next);
                }
            }
        }
        let at = |index: usize| values[..size].get(index).copied().unwrap_or(0);
        let weight = modulus.sum(waves.over_size, waves.over_size);
        for (j, coefficient) in out.iter_mut().enumerate() {
            let sum = match (half_wave, wave) {
                (true, Wave::Cosine) => modulus.sum(at(j), at(j + 1)),
                (true, Wave::Sine) => modulus.difference(at(j), at(j + 1)),
                (false, Wave::Cosine) => at(j),
                (false, Wave::Sine) if j == 0 => 0,
                (false, Wave::Sine) => modulus.difference(at(j - 1), at(j + 1)),
            };
            let mean = (half_wave, wave, j) == (false, Wave::Cosine, 0);
            *coefficient = modulus.product(sum, if mean { waves.over_size } else { weight });
        }
        waves.scratch = scratch;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::residue::{Work, by_widest, portable::Portable, primes_below};

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

        fn by<A: Arithmetic>(self, arithmetic: A) {
            let grid = Grid::new(3 * self.count, self.half_wave);
            let prime = primes_below(A::BITS, grid.circle() as u64).next().expect("a prime");
            let modulus = &Modulus::new(prime, A::RADIX);
            let mut waves = Waves::new(modulus, grid).expect("roots of unity");
            let values = |waves: &mut Waves, wave, coefficients: &[u64]| {
                let mut values = vec![0; padded(grid.size())];
                waves.values((arithmetic, modulus), wave, coefficients, &mut values);
                values
            };
            let given: Vec<u64> = (0..self.count as i64)
                .map(|k| modulus.small(k * k - 7 * k + 3))
                .collect();
            for wave in [Wave::Cosine, Wave::Sine] {
                // Once there and back.
                let mut own = values(&mut waves, wave, &given);
                let mut back = vec![0; self.count + 1];
                let square: Vec<u64> = own.iter().map(|value| modulus.product(*value, *value)).collect();
                let second = values(&mut waves, Wave::Cosine, &[0, modulus.one]);
                waves.coefficients((arithmetic, modulus), wave, &mut own, &mut back);
                let mut expected = given.clone();
                if wave == Wave::Sine && !self.half_wave {
                    expected[0] = 0;
                }
                assert_eq!(back[..self.count], expected);
                assert_eq!(back[self.count], 0);
                // The square times the second cosine: u^2 cos = sum of cosines with harmonics i + j + k and their differences.
                let mut product: Vec<u64> = square.iter().zip(second).map(|(u, v)| modulus.product(*u, v)).collect();
                let mut found = vec![0; 2 * self.count + 1];
                waves.coefficients((arithmetic, modulus), Wave::Cosine, &mut product, &mut found);
                let quarter = modulus.inverse(modulus.small(4));
                let mut sums = vec![0; found.len()];
                let cosine = self.harmonic(1) as i64;
                for (i, left) in expected.iter().enumerate() {
                    for (j, right) in expected.iter().enumerate() {
                        let (m, n) = (self.harmonic(i) as i64, self.harmonic(j) as i64);
                        let term = modulus.product(modulus.product(*left, *right), quarter);
                        let upper = if wave == Wave::Sine {
                            modulus.negative(term)
                        } else {
                            term
                        };
                        for (harmonic, term) in [(m + n, upper), (m - n, term)] {
                            for harmonic in [harmonic + cosine, harmonic - cosine] {
                                let index = harmonic.unsigned_abs() as usize / if self.half_wave { 2 } else { 1 };
                                if let Some(sum) = sums.get_mut(index) {
                                    *sum = modulus.sum(*sum, term);
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
                Products { count, half_wave }.by(Portable::new());
                by_widest(Products { count, half_wave });
            }
        }
    }
}

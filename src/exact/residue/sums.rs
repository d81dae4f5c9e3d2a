//! The sums of products that a series recursion consists of, eight at a time: each function here runs compiled for the processor.

use pulp::NullaryFnOnce;

use super::{Arithmetic, Lanes, Modulus, Rows, WIDTH};

/// A product of two series, both and the product among the same tables.
#[derive(Clone, Copy, Debug)]
pub struct Product {
    /// One factor.
    pub left: usize,
    /// The other; the same for a square, which costs half.
    pub right: usize,
    /// Where the product is written.
    pub to: usize,
    /// The highest order that is wanted.
    pub needed: usize,
}

/// Order `order` of every product, `sum_i left_i right_(order-i)` at each point; a product may be a factor of those after it.
pub fn convolve<A: Arithmetic>(
    arithmetic: A,
    modulus: &Modulus,
    products: &[Product],
    tables: &mut [Rows],
    order: usize,
) {
    struct Convolve<'a, A>(A, &'a Modulus, &'a [Product], &'a mut [Rows], usize);
    impl<A: Arithmetic> NullaryFnOnce for Convolve<'_, A> {
        type Output = ();
        #[inline(always)]
        fn call(self) {
            let Self(arithmetic, modulus, products, tables, order) = self;
            // Block by block: what one product has read, the next finds in the cache.
            for block in 0..tables.first().map_or(0, Rows::blocks) {
                for product in products.iter().filter(|product| order <= product.needed) {
                    let left = &tables[product.left].row(block)[..=order];
                    let right = &tables[product.right].row(block)[..=order];
                    let sum = match product.left == product.right {
                        true => square(arithmetic, left),
                        false => pairs(arithmetic, left, right),
                    };
                    *tables[product.to].entry(block, order) = arithmetic.reduce(sum, modulus);
                }
            }
        }
    }
    arithmetic.vectorize(Convolve(arithmetic, modulus, products, tables, order));
}

/// `sum_i left_i right_(n-i)`: four sums run beside each other, for each has to wait for itself.
#[inline(always)]
fn pairs<A: Arithmetic>(arithmetic: A, left: &[Lanes], right: &[Lanes]) -> A::Sum {
    let mut sums = [arithmetic.none(); 4];
    for (left, right) in left.chunks(4 * A::RUN).zip(right.rchunks(4 * A::RUN)) {
        let (mut left, mut right) = (left.chunks_exact(4), right.rchunks_exact(4));
        for (left, right) in left.by_ref().zip(right.by_ref()) {
            for k in 0..4 {
                sums[k] = arithmetic.add_product(sums[k], &left[k], &right[3 - k]);
            }
        }
        let rest = left.remainder().iter().zip(right.remainder().iter().rev());
        for ((left, right), sum) in rest.zip(&mut sums) {
            *sum = arithmetic.add_product(*sum, left, right);
        }
        // A loop, for a closure would not be compiled for this processor.
        for sum in &mut sums {
            *sum = arithmetic.carry(*sum);
        }
    }
    joined(arithmetic, sums)
}

/// `sum_i u_i u_(n-i)`, each pair once.
#[inline(always)]
fn square<A: Arithmetic>(arithmetic: A, orders: &[Lanes]) -> A::Sum {
    let half = orders.len() / 2;
    let pairs = pairs(arithmetic, &orders[..half], &orders[orders.len() - half..]);
    let twice = arithmetic.join(pairs, pairs);
    match orders.len() % 2 {
        0 => twice,
        _ => arithmetic.add_product(twice, &orders[half], &orders[half]),
    }
}

#[inline(always)]
fn joined<A: Arithmetic>(arithmetic: A, [first, second, third, fourth]: [A::Sum; 4]) -> A::Sum {
    arithmetic.join(arithmetic.join(first, second), arithmetic.join(third, fourth))
}

/// `out = sum_i factors_i row_i` for the first rows, each from the order `first(block)` on: the ones before are zero.
pub fn combine<A: Arithmetic>(
    arithmetic: A,
    modulus: &Modulus,
    factors: &[u64],
    (table, start): (&Rows, usize),
    first: impl Fn(usize) -> usize,
    out: &mut [u64],
) {
    struct Combine<'a, A, F>(A, &'a Modulus, &'a [u64], &'a Rows, usize, F, &'a mut [u64]);
    impl<A: Arithmetic, F: Fn(usize) -> usize> NullaryFnOnce for Combine<'_, A, F> {
        type Output = ();
        #[inline(always)]
        fn call(self) {
            let Self(arithmetic, modulus, factors, table, start, first, out) = self;
            for (block, out) in out.chunks_exact_mut(WIDTH).enumerate() {
                let first = first(block).min(factors.len());
                let row = &table.row(block)[start..start + factors.len()];
                let sum = multiples(arithmetic, &factors[first..], &row[first..]);
                out.copy_from_slice(&arithmetic.reduce(sum, modulus).0);
            }
        }
    }
    arithmetic.vectorize(Combine(arithmetic, modulus, factors, table, start, first, out));
}

/// `sum_i factors_i row_i`.
#[inline(always)]
pub(super) fn multiples<A: Arithmetic>(arithmetic: A, factors: &[u64], row: &[Lanes]) -> A::Sum {
    let mut sums = [arithmetic.none(); 4];
    for (factors, row) in factors.chunks(4 * A::RUN).zip(row.chunks(4 * A::RUN)) {
        let (mut factors, mut row) = (factors.chunks_exact(4), row.chunks_exact(4));
        for (factors, row) in factors.by_ref().zip(row.by_ref()) {
            for k in 0..4 {
                sums[k] = arithmetic.add_multiple(sums[k], factors[k], &row[k]);
            }
        }
        for ((factor, entry), sum) in factors.remainder().iter().zip(row.remainder()).zip(&mut sums) {
            *sum = arithmetic.add_multiple(*sum, *factor, entry);
        }
        // A loop, for a closure would not be compiled for this processor.
        for sum in &mut sums {
            *sum = arithmetic.carry(*sum);
        }
    }
    joined(arithmetic, sums)
}

/// One series of a [mixture], at one order.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// What it is multiplied by.
    pub factor: u64,
    /// Its place among the tables.
    pub table: usize,
    /// The order.
    pub order: usize,
}

/// `out = sum of factor table_order` over a few parts, at every point.
pub fn mixture<A: Arithmetic>(arithmetic: A, modulus: &Modulus, parts: &[Part], tables: &[Rows], out: &mut [u64]) {
    struct Mixture<'a, A>(A, &'a Modulus, &'a [Part], &'a [Rows], &'a mut [u64]);
    impl<A: Arithmetic> NullaryFnOnce for Mixture<'_, A> {
        type Output = ();
        #[inline(always)]
        fn call(self) {
            let Self(arithmetic, modulus, parts, tables, out) = self;
            for (block, out) in out.chunks_exact_mut(WIDTH).enumerate() {
                let mut sum = arithmetic.none();
                for parts in parts.chunks(A::RUN) {
                    for part in parts {
                        let entry = &tables[part.table].row(block)[part.order];
                        sum = arithmetic.add_multiple(sum, part.factor, entry);
                    }
                    sum = arithmetic.carry(sum);
                }
                out.copy_from_slice(&arithmetic.reduce(sum, modulus).0);
            }
        }
    }
    arithmetic.vectorize(Mixture(arithmetic, modulus, parts, tables, out));
}

/// One order of a table changed by `factor` times `change`, at every point.
pub fn vary<A: Arithmetic>(
    arithmetic: A,
    modulus: &Modulus,
    (table, order): (&mut Rows, usize),
    factor: u64,
    change: &[u64],
) {
    struct Vary<'a, A>(A, &'a Modulus, &'a mut Rows, usize, u64, &'a [u64]);
    impl<A: Arithmetic> NullaryFnOnce for Vary<'_, A> {
        type Output = ();
        #[inline(always)]
        fn call(self) {
            let Self(arithmetic, modulus, table, order, factor, change) = self;
            for (block, change) in change.chunks_exact(WIDTH).enumerate() {
                let mut own = Lanes::default();
                own.0.copy_from_slice(change);
                let entry = table.entry(block, order);
                let sum = arithmetic.add_multiple(arithmetic.none(), modulus.one, entry);
                *entry = arithmetic.reduce(arithmetic.add_multiple(sum, factor, &own), modulus);
            }
        }
    }
    arithmetic.vectorize(Vary(arithmetic, modulus, table, order, factor, change));
}

/// `values *= factors`, one by one, whole [`Lanes`] of them.
pub fn multiply<A: Arithmetic>(arithmetic: A, modulus: &Modulus, values: &mut [u64], factors: &[u64]) {
    struct Multiply<'a, A>(A, &'a Modulus, &'a mut [u64], &'a [u64]);
    impl<A: Arithmetic> NullaryFnOnce for Multiply<'_, A> {
        type Output = ();
        #[inline(always)]
        fn call(self) {
            let Self(arithmetic, modulus, values, factors) = self;
            multiply_here(arithmetic, modulus, values, factors);
        }
    }
    arithmetic.vectorize(Multiply(arithmetic, modulus, values, factors));
}

/// As [`multiply`], within a function that is compiled for the processor already.
#[inline(always)]
pub fn multiply_here<A: Arithmetic>(arithmetic: A, modulus: &Modulus, values: &mut [u64], factors: &[u64]) {
    for (values, factors) in values.chunks_exact_mut(WIDTH).zip(factors.chunks_exact(WIDTH)) {
        let (mut left, mut right) = (Lanes::default(), Lanes::default());
        left.0.copy_from_slice(values);
        right.0.copy_from_slice(factors);
        let product = arithmetic.add_product(arithmetic.none(), &left, &right);
        values.copy_from_slice(&arithmetic.reduce(product, modulus).0);
    }
}

/// As [`combine`] over all rows from the first order on, within a function that is compiled for the processor already; four rows
/// share what they are multiplied by.
#[inline(always)]
pub fn combine_here<A: Arithmetic>(arithmetic: A, modulus: &Modulus, factors: &[u64], table: &Rows, out: &mut [u64]) {
    let blocks = out.len() / WIDTH;
    let mut block = 0;
    while block + 4 <= blocks {
        let row = |k: usize| &table.row(block + k)[..factors.len()];
        let rows = [row(0), row(1), row(2), row(3)];
        let mut sums = [arithmetic.none(); 4];
        let mut start = 0;
        while start < factors.len() {
            let end = (start + A::RUN).min(factors.len());
            for i in start..end {
                for k in 0..4 {
                    sums[k] = arithmetic.add_multiple(sums[k], factors[i], &rows[k][i]);
                }
            }
            // A loop, for a closure would not be compiled for this processor.
            for sum in &mut sums {
                *sum = arithmetic.carry(*sum);
            }
            start = end;
        }
        for (sum, out) in sums.iter().zip(out[block * WIDTH..].chunks_exact_mut(WIDTH)) {
            out.copy_from_slice(&arithmetic.reduce(*sum, modulus).0);
        }
        block += 4;
    }
    for block in block..blocks {
        let sum = multiples(arithmetic, factors, &table.row(block)[..factors.len()]);
        out[block * WIDTH..(block + 1) * WIDTH].copy_from_slice(&arithmetic.reduce(sum, modulus).0);
    }
}

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

/// Orders whose sums over all orders before them are formed together: a row of the tables is read once for all of them.
const TOGETHER: usize = 8;

/// Order `order` of every product, `sum_i left_i right_(order-i)` at each point; a product may be a factor of those after it.
/// The orders come one after the other, from zero on.
///
/// What is already there of a product at the orders that follow is kept in its own table. Cost: a multiplication for each pair of
/// orders and each point, half of them for a square.
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
            // The first orders are as fast one by one.
            let start = if order < 2 * TOGETHER {
                0
            } else {
                order - order % TOGETHER
            };
            // Block by block: what one product has read, the next finds in the cache.
            for block in 0..tables.first().map_or(0, Rows::blocks) {
                if order == start && start > 0 {
                    for product in products.iter().filter(|product| order <= product.needed) {
                        prepare(arithmetic, modulus, product, tables, block, start);
                    }
                }
                for product in products.iter().filter(|product| order <= product.needed) {
                    let left = &tables[product.left].row(block)[..=order];
                    let right = &tables[product.right].row(block)[..=order];
                    let square = product.left == product.right;
                    let sum = if start == 0 {
                        match square {
                            true => self::square(arithmetic, left),
                            false => pairs(arithmetic, left, right),
                        }
                    } else {
                        let recent = order - start + 1;
                        let first = pairs(arithmetic, &left[..recent], &right[start..]);
                        let last = match square {
                            true => first,
                            false => pairs(arithmetic, &left[start..], &right[..recent]),
                        };
                        let before = &tables[product.to].row(block)[order];
                        let sum = arithmetic.carry(arithmetic.merge(first, last));
                        arithmetic.add_multiple(sum, modulus.one, before)
                    };
                    *tables[product.to].entry(block, order) = arithmetic.reduce(sum, modulus);
                }
            }
        }
    }
    arithmetic.vectorize(Convolve(arithmetic, modulus, products, tables, order));
}

/// The part of a product at the orders from `start` on in which both factors are of orders before it.
#[inline(always)]
fn prepare<A: Arithmetic>(
    arithmetic: A,
    modulus: &Modulus,
    product: &Product,
    tables: &mut [Rows],
    block: usize,
    start: usize,
) {
    let orders = tables[product.to].row(block).len();
    for first in [start, start + TOGETHER / 2] {
        let left = &tables[product.left].row(block)[..start];
        let right = &tables[product.right].row(block)[..start];
        let mut sums = [arithmetic.none(); 4];
        // Of a square the terms below the middle, twice, and the middle.
        let square = product.left == product.right;
        let end = if square { first / 2 } else { start };
        window(arithmetic, (left, right), (start, first), end, &mut sums);
        if square {
            for (k, sum) in sums.iter_mut().enumerate() {
                let order = first + k;
                for i in end.max(order - start + 1)..order.div_ceil(2) {
                    *sum = arithmetic.add_product(*sum, &left[i], &left[order - i]);
                }
                *sum = arithmetic.join(*sum, *sum);
                if order % 2 == 0 && order / 2 < start {
                    *sum = arithmetic.add_product(*sum, &left[order / 2], &left[order / 2]);
                }
            }
        }
        for (k, sum) in sums.into_iter().enumerate() {
            if first + k < orders {
                *tables[product.to].entry(block, first + k) = arithmetic.reduce(sum, modulus);
            }
        }
    }
}

/// `sum_i left_i right_(order-i)` for four orders from `first` on, over all `i < end` for which both are below `start`: each entry
/// that is loaded serves four sums.
#[inline(always)]
fn window<A: Arithmetic>(
    arithmetic: A,
    (left, right): (&[Lanes], &[Lanes]),
    (start, first): (usize, usize),
    end: usize,
    sums: &mut [A::Sum; 4],
) {
    let shared = first - start + 4;
    for (k, sum) in sums.iter_mut().enumerate() {
        for i in first + k - start + 1..shared.min(end) {
            *sum = arithmetic.add_product(*sum, &left[i], &right[first + k - i]);
        }
        *sum = arithmetic.carry(*sum);
    }
    // By name, so that they stay in registers.
    let [mut a, mut b, mut c, mut d] = *sums;
    let mut from = shared;
    while from < end {
        let to = (from + A::RUN).min(end);
        let fours = right[first + 1 - to..first - from + 4].windows(4).rev();
        for (left, four) in left[from..to].iter().zip(fours) {
            if let [zeroth, first, second, third] = four {
                a = arithmetic.add_product(a, left, zeroth);
                b = arithmetic.add_product(b, left, first);
                c = arithmetic.add_product(c, left, second);
                d = arithmetic.add_product(d, left, third);
            }
        }
        a = arithmetic.carry(a);
        b = arithmetic.carry(b);
        c = arithmetic.carry(c);
        d = arithmetic.carry(d);
        from = to;
    }
    *sums = [a, b, c, d];
}

/// `sum_i left_i right_(n-i)` over so few, twice [those](TOGETHER), that nothing has to be carried: two sums run beside each other, for
/// each has to wait for itself.
#[inline(always)]
fn pairs<A: Arithmetic>(arithmetic: A, left: &[Lanes], right: &[Lanes]) -> A::Sum {
    const { assert!(2 * TOGETHER <= A::RUN) };
    let (mut even, mut odd) = (arithmetic.none(), arithmetic.none());
    let (mut lefts, mut rights) = (left.chunks_exact(2), right.rchunks_exact(2));
    for (left, right) in lefts.by_ref().zip(rights.by_ref()) {
        even = arithmetic.add_product(even, &left[0], &right[1]);
        odd = arithmetic.add_product(odd, &left[1], &right[0]);
    }
    if let ([left], [right]) = (lefts.remainder(), rights.remainder()) {
        even = arithmetic.add_product(even, left, right);
    }
    arithmetic.merge(even, odd)
}

/// `sum_i u_i u_(n-i)`, each pair once.
#[inline(always)]
fn square<A: Arithmetic>(arithmetic: A, orders: &[Lanes]) -> A::Sum {
    let half = orders.len() / 2;
    let pairs = pairs(arithmetic, &orders[..half], &orders[orders.len() - half..]);
    let twice = arithmetic.merge(pairs, pairs);
    match orders.len() % 2 {
        0 => twice,
        _ => arithmetic.add_product(twice, &orders[half], &orders[half]),
    }
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
    let none = arithmetic.none();
    // By name, so that they stay in registers.
    let (mut a, mut b, mut c, mut d) = (none, none, none, none);
    for (factors, row) in factors.chunks(4 * A::RUN).zip(row.chunks(4 * A::RUN)) {
        let (mut factors, mut row) = (factors.chunks_exact(4), row.chunks_exact(4));
        for (factors, row) in factors.by_ref().zip(row.by_ref()) {
            a = arithmetic.add_multiple(a, factors[0], &row[0]);
            b = arithmetic.add_multiple(b, factors[1], &row[1]);
            c = arithmetic.add_multiple(c, factors[2], &row[2]);
            d = arithmetic.add_multiple(d, factors[3], &row[3]);
        }
        let mut rest = factors.remainder().iter().zip(row.remainder());
        if let Some((factor, entry)) = rest.next() {
            a = arithmetic.add_multiple(a, *factor, entry);
        }
        if let Some((factor, entry)) = rest.next() {
            b = arithmetic.add_multiple(b, *factor, entry);
        }
        if let Some((factor, entry)) = rest.next() {
            c = arithmetic.add_multiple(c, *factor, entry);
        }
        a = arithmetic.carry(a);
        b = arithmetic.carry(b);
        c = arithmetic.carry(c);
        d = arithmetic.carry(d);
    }
    arithmetic.join(arithmetic.join(a, b), arithmetic.join(c, d))
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
        values.copy_from_slice(&arithmetic.product(&left, &right, modulus).0);
    }
}

/// As [`combine`] over all rows from the first order on, within a function that is compiled for the processor already; four rows
/// share what they are multiplied by.
#[inline(always)]
pub fn combine_here<A: Arithmetic>(arithmetic: A, modulus: &Modulus, factors: &[u64], table: &Rows, out: &mut [u64]) {
    let blocks = out.len() / WIDTH;
    let mut block = 0;
    while block + 4 <= blocks {
        let rows = [
            table.row(block),
            table.row(block + 1),
            table.row(block + 2),
            table.row(block + 3),
        ];
        let rows = rows.map(|row| &row[..factors.len()]);
        let none = arithmetic.none();
        // By name, so that they stay in registers.
        let (mut a, mut b, mut c, mut d) = (none, none, none, none);
        let mut start = 0;
        while start < factors.len() {
            let end = (start + A::RUN).min(factors.len());
            let [first, second, third, fourth] = rows.map(|row| &row[start..end]);
            let pairs = first.iter().zip(second).zip(third.iter().zip(fourth));
            for (factor, ((first, second), (third, fourth))) in factors[start..end].iter().zip(pairs) {
                a = arithmetic.add_multiple(a, *factor, first);
                b = arithmetic.add_multiple(b, *factor, second);
                c = arithmetic.add_multiple(c, *factor, third);
                d = arithmetic.add_multiple(d, *factor, fourth);
            }
            a = arithmetic.carry(a);
            b = arithmetic.carry(b);
            c = arithmetic.carry(c);
            d = arithmetic.carry(d);
            start = end;
        }
        for (sum, out) in [a, b, c, d]
            .into_iter()
            .zip(out[block * WIDTH..].chunks_exact_mut(WIDTH))
        {
            out.copy_from_slice(&arithmetic.reduce(sum, modulus).0);
        }
        block += 4;
    }
    for block in block..blocks {
        let sum = multiples(arithmetic, factors, &table.row(block)[..factors.len()]);
        out[block * WIDTH..(block + 1) * WIDTH].copy_from_slice(&arithmetic.reduce(sum, modulus).0);
    }
}

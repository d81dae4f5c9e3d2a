//! The sums of products of a series recursion, eight at a time: each function here is compiled for
//! the processor, or inlined into one that is.

use pulp::NullaryFnOnce;

use super::{Arithmetic, Lanes, Residues, Tables};

/// A product of two series; the factors and the product are tables of one set.
#[derive(Clone, Copy, Debug)]
pub struct Product {
    /// Index of the table of one factor.
    pub left: usize,
    /// Index of the table of the other; the same for a square, which costs half.
    pub right: usize,
    /// Index of the table of the product.
    pub to: usize,
    /// The highest order that is needed.
    pub needed: usize,
}

/// Number of orders whose sums over all orders before them are formed together: a row of the tables
/// is read once for all of them.
pub const TOGETHER: usize = 8;

/// Computes order `order` of every product, `sum_i left_i right_(order-i)`, at each point; a
/// product may be a factor of the products after it. The orders must be computed one after the
/// other, from zero on.
///
/// The part of a product that is known in advance at the following orders is kept in its own table,
/// which may hold only the latest orders: [`TOGETHER`] of them and those that are needed later.
/// Cost: a multiplication for each pair of orders and each point, half of them for a square.
#[inline(always)]
pub fn convolve<A: Arithmetic>(
    residues: &Residues<A>,
    products: &[Product],
    tables: &mut Tables,
    order: usize,
) {
    struct Convolve<'a, 'm, A>(&'a Residues<A>, &'a [Product], &'a mut Tables<'m>, usize);
    impl<A: Arithmetic> NullaryFnOnce for Convolve<'_, '_, A> {
        type Output = ();
        #[inline(always)]
        fn call(self) {
            let Self(residues, products, tables, order) = self;
            let arithmetic = residues.arithmetic;
            // At the first orders the sums are too short for blocks to pay.
            let start = if order < 2 * TOGETHER { 0 } else { order - order % TOGETHER };
            // The loop runs point by point, so that a product finds in the cache what the one
            // before it has read.
            for point in 0..tables.rows() {
                if order == start && start > 0 {
                    for product in products {
                        if order <= product.needed {
                            prepare(residues, product, tables, point, start);
                        }
                    }
                }
                for product in products {
                    if order > product.needed {
                        continue;
                    }
                    let left = &tables.row(product.left, point)[..=order];
                    let right = &tables.row(product.right, point)[..=order];
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
                        let before =
                            &tables.row(product.to, point)[tables.offset(product.to, order)];
                        let sum = arithmetic.carry(arithmetic.merge(first, last));
                        arithmetic.add_product(sum, &residues.moduli.one, before)
                    };
                    let place = tables.offset(product.to, order);
                    *tables.entry(product.to, point, place) = residues.reduce(sum);
                }
            }
        }
    }
    residues.arithmetic.vectorize(Convolve(residues, products, tables, order));
}

/// Computes the part of a product at the orders from `start` on in which both factors have orders
/// below `start`.
#[inline(always)]
fn prepare<A: Arithmetic>(
    residues: &Residues<A>,
    product: &Product,
    tables: &mut Tables,
    point: usize,
    start: usize,
) {
    let arithmetic = residues.arithmetic;
    let (orders, place) = (tables.row(product.to, point).len(), tables.offset(product.to, start));
    for first in [start, start + TOGETHER / 2] {
        let left = &tables.row(product.left, point)[..start];
        let right = &tables.row(product.right, point)[..start];
        let mut sums = [arithmetic.none(); 4];
        // A square is twice the sum of the terms below the middle, plus the middle.
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
            let place = place + (first - start) + k;
            if place < orders {
                *tables.entry(product.to, point, place) = residues.reduce(sum);
            }
        }
    }
}

/// `sum_i left_i right_(order-i)` for four orders from `first` on, over all `i < end` for which
/// both are below `start`: each entry that is loaded serves four sums.
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
    // Sums with a name of their own stay in registers.
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

/// `sum_i left_i right_(n-i)` over at most `2 * TOGETHER` terms, so few that nothing has to be
/// carried. Two independent sums are computed side by side, so that no addition waits for the one
/// before it.
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

/// `sum_i left_i right_(n-i)` over all terms.
#[inline(always)]
pub fn reversed_products<A: Arithmetic>(arithmetic: A, left: &[Lanes], right: &[Lanes]) -> A::Sum {
    let mut sum = arithmetic.none();
    for (left, right) in left.chunks(2 * TOGETHER).zip(right.rchunks(2 * TOGETHER)) {
        sum = arithmetic.carry(arithmetic.join(sum, pairs(arithmetic, left, right)));
    }
    sum
}

/// `sum_i factors_i row_i`, where each factor is the same in all eight lanes.
#[inline(always)]
pub(super) fn multiples<A: Arithmetic>(arithmetic: A, factors: &[u64], row: &[Lanes]) -> A::Sum {
    let none = arithmetic.none();
    // Sums with a name of their own stay in registers.
    let (mut a, mut b) = (none, none);
    for (factors, row) in factors.chunks(2 * A::RUN).zip(row.chunks(2 * A::RUN)) {
        let (mut factors, mut row) = (factors.chunks_exact(2), row.chunks_exact(2));
        for (factors, row) in factors.by_ref().zip(row.by_ref()) {
            a = arithmetic.add_multiple(a, factors[0], &row[0]);
            b = arithmetic.add_multiple(b, factors[1], &row[1]);
        }
        if let ([factor], [entry]) = (factors.remainder(), row.remainder()) {
            a = arithmetic.add_multiple(a, *factor, entry);
        }
        a = arithmetic.carry(a);
        b = arithmetic.carry(b);
    }
    arithmetic.join(a, b)
}

/// One series of a [mixture], at one order.
#[derive(Clone, Copy, Debug)]
pub struct MixtureTerm {
    /// The factor of the series.
    pub factor: Lanes,
    /// Index of the table of the series.
    pub table: usize,
    /// The order.
    pub order: usize,
}

/// `out = sum of factor table_order` over a few terms, at every point.
#[inline(always)]
pub fn mixture<A: Arithmetic>(
    residues: &Residues<A>,
    parts: &[MixtureTerm],
    tables: &Tables,
    out: &mut [Lanes],
) {
    let arithmetic = residues.arithmetic;
    for (point, out) in out.iter_mut().enumerate() {
        let mut sum = arithmetic.none();
        for parts in parts.chunks(A::RUN) {
            for part in parts {
                let entry = &tables.row(part.table, point)[tables.offset(part.table, part.order)];
                sum = arithmetic.add_product(sum, &part.factor, entry);
            }
            sum = arithmetic.carry(sum);
        }
        *out = residues.reduce(sum);
    }
}

/// Adds `factor` times `change` to one order of a table, at every point.
#[inline(always)]
pub fn vary<A: Arithmetic>(
    residues: &Residues<A>,
    tables: &mut Tables,
    (table, order): (usize, usize),
    factor: Lanes,
    change: &[Lanes],
) {
    let place = tables.offset(table, order);
    for (point, change) in change.iter().enumerate() {
        let entry = tables.entry(table, point, place);
        *entry = residues.sum(*entry, residues.product(factor, *change));
    }
}

/// `values *= factors`, one by one.
#[inline(always)]
pub fn multiply<A: Arithmetic>(residues: &Residues<A>, values: &mut [Lanes], factors: &[Lanes]) {
    for (value, factor) in values.iter_mut().zip(factors) {
        *value = residues.product(*value, *factor);
    }
}

/// `values -= others`, one by one.
#[inline(always)]
pub fn subtract<A: Arithmetic>(residues: &Residues<A>, values: &mut [Lanes], others: &[Lanes]) {
    for (value, other) in values.iter_mut().zip(others) {
        *value = residues.difference(*value, *other);
    }
}

/// `sums += factor values`, one by one.
#[inline(always)]
pub fn add_multiple<A: Arithmetic>(
    residues: &Residues<A>,
    sums: &mut [Lanes],
    factor: Lanes,
    values: &[Lanes],
) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum = residues.sum(*sum, residues.product(factor, *value));
    }
}

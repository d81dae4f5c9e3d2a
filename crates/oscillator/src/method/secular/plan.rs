//! The plan of an expansion by primes, the same for every prime: products, symmetries and points.
//!
//! Half-wave symmetry (every `p + q` odd: odd harmonics alone) and that under reversal of time,
//! where `y_n` consists of cosines (every `q` even) or of cosines for even `n` and of sines for odd
//! `n` (every `q` as even as the order of its term). An equation without the second symmetry is
//! left to the recursion in the ring.

use std::ops::Range;

use super::sine::Sine;
use super::{AmplitudeKind, Scheme};
use crate::exact::Rational;
use crate::exact::residue::Lanes;
use crate::exact::residue::sums::Product;
use crate::series::waves::{Grid, Wave};
use crate::solution::AmplitudeConvention;

/// A term `delta^order coefficient y^position (omega y')^velocity` of the force.
#[derive(Clone, Debug)]
pub(super) struct PlannedTerm {
    pub order: usize,
    pub position: u32,
    pub velocity: u32,
    pub coefficient: Rational,
}

/// The part of an expansion that is the same for every prime: the products, their symmetries and
/// the points at which they are formed.
pub(super) struct Plan<'a> {
    pub terms: &'a [PlannedTerm],
    pub scheme: Scheme,
    /// The highest order that is kept; the amplitude of a limit cycle follows from one order more.
    pub highest: usize,
    pub last: usize,
    pub half_wave: bool,
    /// Sines at odd orders.
    alternating: bool,
    /// Number of harmonics that each order adds.
    growth: usize,
    pub grid: Grid,
    /// The tables of values: `y`, `omega y'` where it is needed, and products of those before.
    pub tables: usize,
    pub products: Vec<Product>,
    /// Index of the table of each term, and whether the term is the derivative of that table.
    pub of_terms: Vec<(usize, bool)>,
    pub has_velocity: bool,
    /// Whether harmonics on which the frequency of the last order does not depend are left out.
    frequency_alone: bool,
    /// Start of the coefficients of each order in a list of all, and the end of the last.
    pub starts: Vec<usize>,
    /// A sine in addition to the terms, with its rate.
    pub sine: Option<(Sine, Rational)>,
}

impl<'a> Plan<'a> {
    /// `None` for an equation without the symmetry under reversal of time, and for one without
    /// terms. With `frequency_alone` only the frequency in the image is correct; `sine` is the rate
    /// of a [sine](super::sine) in addition to the terms, for a free motion.
    pub fn new(
        terms: &'a [PlannedTerm],
        sine: Option<Rational>,
        highest: usize,
        scheme: Scheme,
        frequency_alone: bool,
    ) -> Option<Self> {
        let conservative = terms.iter().all(|term| term.velocity % 2 == 0);
        let alternating = terms.iter().all(|term| term.velocity as usize % 2 == term.order % 2);
        if !(conservative || alternating)
            || terms.iter().any(|term| term.position + term.velocity == 0)
        {
            return None;
        }
        let power = |term: &PlannedTerm| (term.position + term.velocity) as usize;
        let half_wave = terms.iter().all(|term| power(term) % 2 == 1);
        let growths = terms.iter().map(|term| (power(term) - 1).div_ceil(term.order));
        let growth = growths.chain(sine.as_ref().map(|_| 2)).max()?;
        let determined = scheme.amplitude == AmplitudeKind::Determined;
        let last = highest + usize::from(determined);
        // The frequency of a limit cycle does not depend on the normalisation of its motion.
        // Without an initial value, which is a sum over all harmonics, the high ones are not
        // needed. The frequency of a free motion does depend on the definition of its amplitude.
        let frequency_alone = frequency_alone
            && (determined || scheme.normalisation == AmplitudeConvention::FirstHarmonic);
        let normalisation = match frequency_alone {
            true => AmplitudeConvention::FirstHarmonic,
            false => scheme.normalisation,
        };
        let mut plan = Self {
            terms,
            scheme: Scheme { normalisation, ..scheme },
            highest,
            last,
            half_wave,
            alternating: !conservative,
            growth,
            grid: Grid::new(1, half_wave),
            tables: 1,
            products: vec![],
            of_terms: vec![],
            has_velocity: terms.iter().any(|term| term.velocity > 1),
            frequency_alone,
            starts: Vec::with_capacity(last + 2),
            sine: None,
        };
        let mut end = 0;
        plan.starts.push(end);
        for order in 0..=last {
            end += plan.harmonics(order);
            plan.starts.push(end);
        }
        plan.grid = Grid::new(plan.points(), half_wave);
        plan.tables += usize::from(plan.has_velocity);
        plan.of_terms = terms.iter().map(|term| plan.table_of(term)).collect();
        if let Some(rate) = sine {
            plan.sine = Some((Sine::new(plan.tables, last), rate));
            plan.tables += Sine::TABLES;
        }
        Some(plan)
    }

    fn table_of(&mut self, term: &PlannedTerm) -> (usize, bool) {
        let needed = self.last.saturating_sub(term.order);
        match (term.position, term.velocity) {
            (position, 0) => (self.power(0, position, needed), false),
            (position, 1) => (self.power(0, position + 1, needed), true),
            (0, velocity) => (self.power(1, velocity, needed), false),
            (position, velocity) => {
                let (position, velocity) =
                    (self.power(0, position, needed), self.power(1, velocity, needed));
                (self.product(position, velocity, needed), false)
            }
        }
    }

    /// The power by steps of two, so that neighbouring powers share their products.
    fn power(&mut self, base: usize, exponent: u32, needed: usize) -> usize {
        if exponent <= 1 {
            return base;
        }
        let square = self.product(base, base, needed);
        let start = if exponent.is_multiple_of(2) { square } else { base };
        (1..exponent.div_ceil(2)).fold(start, |power, _| self.product(power, square, needed))
    }

    fn product(&mut self, left: usize, right: usize, needed: usize) -> usize {
        let (left, right) = (left.min(right), left.max(right));
        let known =
            self.products.iter_mut().find(|known| (known.left, known.right) == (left, right));
        if let Some(known) = known {
            known.needed = known.needed.max(needed);
            return known.to;
        }
        let to = self.tables;
        self.tables += 1;
        self.products.push(Product { left, right, to, needed });
        to
    }

    /// Largest number of harmonics of `y_order`: `1, 3, ...` or `0, 1, 2, ...`.
    fn harmonics_in_reach(&self, order: usize) -> usize {
        match self.half_wave {
            true => order * self.growth / 2 + 1,
            false => order * self.growth + 2,
        }
    }

    /// Number of harmonics of `y_order` that are computed. If only the frequency is wanted, those
    /// that can no longer reach the first harmonic of the last order are left out: each order
    /// shifts a harmonic by no more than its own reach.
    pub fn harmonics(&self, order: usize) -> usize {
        match self.frequency_alone {
            true => {
                self.harmonics_in_reach(order).min(self.harmonics_in_reach(self.last - order) + 1)
            }
            false => self.harmonics_in_reach(order),
        }
    }

    /// The places of an order's coefficients in a list of those of all orders.
    pub fn coefficient_range(&self, order: usize) -> Range<usize> {
        self.starts[order]..self.starts[order] + self.harmonics(order)
    }

    /// Number of points that resolve the harmonics: with `K` of them, index `j` of a product is
    /// aliased to `2K - 1 - j` (`2K - j` if all harmonics occur), which must not be an index that
    /// is computed.
    fn points(&self) -> usize {
        match self.frequency_alone {
            true => self.harmonics_in_reach(self.last) / 2 + self.growth + 3,
            // One more than the harmonics of the last order, of which only the first is used.
            false => self.harmonics_in_reach(self.last) + 1,
        }
    }

    /// The number of harmonics of the order that has the most.
    pub fn most_harmonics(&self) -> usize {
        let orders = (0..=self.last).map(|order| self.harmonics(order));
        orders.max().unwrap_or(0).max(self.resonant() + 1)
    }

    /// The harmonic of an index.
    pub fn harmonic(&self, index: usize) -> usize {
        if self.half_wave { 2 * index + 1 } else { index }
    }

    /// The first harmonic's index.
    pub fn resonant(&self) -> usize {
        usize::from(!self.half_wave)
    }

    /// The kind of series of `y_order`, cosines or sines.
    pub fn wave(&self, order: usize) -> Wave {
        match self.alternating && order % 2 == 1 {
            true => Wave::Sine,
            false => Wave::Cosine,
        }
    }

    /// The order of the root of unity: a prime minus one has to be a multiple of it.
    pub fn circle(&self) -> u64 {
        self.grid.circle() as u64
    }

    /// The largest divisor of the elimination at an order, `k^2 - 1`, has no prime factor above
    /// this.
    pub fn largest_factor(&self, order: usize) -> u64 {
        let highest = self.harmonic(self.harmonics_in_reach(order) - 1) as u64 + 1;
        if self.half_wave { highest / 2 } else { highest }
    }

    /// The largest prime factor of the divisors of the frequency: a contribution that returns to
    /// the first harmonic was no further away than half of the orders reach, but for the initial
    /// value of a free motion, which is a sum over all harmonics.
    pub fn largest_factor_of_frequency(&self, order: usize) -> u64 {
        let free = self.scheme.amplitude == AmplitudeKind::Free;
        match free && self.scheme.normalisation == AmplitudeConvention::Initial {
            true => self.largest_factor(order),
            false => self.largest_factor(order / 2),
        }
    }

    /// The distance between neighbouring orders of the same symmetry.
    #[inline(always)]
    pub fn step(&self) -> usize {
        if self.alternating { 2 } else { 1 }
    }

    /// The first order with the symmetry of this one at which a harmonic need not be zero.
    #[inline(always)]
    pub fn first(&self, index: usize, order: usize) -> usize {
        let first = match self.half_wave {
            true => (2 * index).div_ceil(self.growth.max(1)),
            false => index.saturating_sub(1).div_ceil(self.growth.max(1)),
        };
        first + (first + order) % self.step()
    }

    /// The products of the sine.
    pub fn sine_products(&self) -> impl Iterator<Item = &Product> {
        let sine = self.sine.iter();
        sine.flat_map(|(sine, _)| [&sine.of_sine, &sine.of_cosine])
    }
}

/// Coefficients of harmonics: one row for each harmonic and each symmetry, with the orders at which
/// it is not zero, all in one slice.
pub(super) struct HarmonicTable<'m> {
    rows: [Vec<OrderRange>; 2],
    entries: &'m mut [Lanes],
}

/// Start of a row and the number of its orders.
#[derive(Clone, Copy)]
struct OrderRange {
    begin: usize,
    length: usize,
}

impl<'m> HarmonicTable<'m> {
    /// Number of entries of this many harmonics.
    pub fn entry_count(plan: &Plan, count: usize) -> usize {
        let parities = 0..plan.step();
        parities
            .map(|parity| (0..count).map(|index| Self::orders(plan, index, parity)).sum::<usize>())
            .sum()
    }

    /// The orders of a symmetry at which a harmonic need not be zero.
    fn orders(plan: &Plan, index: usize, parity: usize) -> usize {
        (plan.last + 1).saturating_sub(plan.first(index, parity)).div_ceil(plan.step())
    }

    /// A table of this many harmonics, in memory of [this size](Self::entry_count).
    pub fn new(plan: &Plan, count: usize, entries: &'m mut [Lanes]) -> Self {
        let mut end = 0;
        let mut rows = |parity: usize| -> Vec<OrderRange> {
            let row = |index| {
                let begin = end;
                end += Self::orders(plan, index, parity);
                OrderRange { begin, length: 0 }
            };
            (0..count).map(row).collect()
        };
        Self { rows: [rows(0), if plan.step() == 2 { rows(1) } else { vec![] }], entries }
    }

    pub fn clear(&mut self) {
        self.rows.iter_mut().flatten().for_each(|row| row.length = 0);
    }

    /// All entries.
    pub fn entries(&mut self) -> impl Iterator<Item = &mut Lanes> {
        self.entries.iter_mut()
    }

    fn parity(&self, order: usize) -> usize {
        if self.rows[1].is_empty() { 0 } else { order % 2 }
    }

    /// Appends the coefficients of the next order.
    pub fn push(&mut self, plan: &Plan, order: usize, coefficients: &[Lanes]) {
        let parity = self.parity(order);
        for (index, (row, coefficient)) in
            self.rows[parity].iter_mut().zip(coefficients).enumerate()
        {
            if plan.first(index, order) <= order {
                self.entries[row.begin + row.length] = *coefficient;
                row.length += 1;
            }
        }
    }

    /// The coefficient at the last order with the symmetry of `order`.
    pub fn last(&mut self, order: usize, index: usize) -> Option<&mut Lanes> {
        let row = self.rows[self.parity(order)].get(index)?;
        let last = row.length.checked_sub(1)?;
        self.entries.get_mut(row.begin + last)
    }

    /// The first order of a row and its entries, for the symmetry of an order.
    #[inline(always)]
    pub fn row(&self, plan: &Plan, index: usize, order: usize) -> (usize, &[Lanes]) {
        let parity = if plan.step() == 2 { order % 2 } else { 0 };
        let row = self.rows[parity][index];
        (plan.first(index, order), &self.entries[row.begin..][..row.length])
    }

    pub fn coefficient(&self, plan: &Plan, index: usize, order: usize) -> Lanes {
        let (first, row) = self.row(plan, index, order);
        let place = order.checked_sub(first).map(|after| after / plan.step());
        place.and_then(|place| row.get(place)).copied().unwrap_or_default()
    }
}

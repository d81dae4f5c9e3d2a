//! An exact expansion whose coefficients contain symbols, reconstructed from its images modulo
//! primes at many values of the symbols.
//!
//! References: J. von zur Gathen and J. Gerhard, *Modern Computer Algebra*, Cambridge 2013,
//! section 5.5 (change of representation).
//!
//! ```text
//! sum_t c_t delta^(a_t) y^(p_t) (omega y')^(q_t):   order n = sum K_e prod c_t^(e_t)   over all e with sum a_t e_t = n
//! c_1 = 1 for a term with a_1 = 1:  the others, u, have sum a_t e_t <= n, a lower set, and K_e follow from values at u_t = e_t
//! ```
//!
//! Terms with the same power of the small parameter and the same symbols share one `u`. At each
//! point the recursion is that over [residues](super::modular); the fractions are found by the
//! remainders of a few primes, and tried modulo one prime more. At a few points the recursion in
//! [one word or two](super::fixed_width) takes the place of primes.
//!
//! Cost: for `P` points in the lower set of the highest order, `P` runs of the recursion for each
//! prime, where products of polynomials would take `P^2` products of coefficients each. The points
//! are independent, and run on all threads with one result; those of the lowest orders come first,
//! so that an interrupted computation has all points of the lower orders.
//!
//! Memory: the residues of all coefficients, 8 bytes for each prime, at most half a gigabyte.

use num_traits::{One, Zero, cast};

use super::fixed_width;
use super::lower_set::{LowerSet, PointField};
use super::modular::{Recursion, ResidueField};
use super::plan::{Plan, PlannedTerm};
use super::{AmplitudeKind, ExpansionScope, ForceTerm, Scheme, SecularExpansion};
use crate::exact::residue::remainder::{ReconstructedIntegers, Remainders, fraction};
use crate::exact::residue::{
    Arithmetic, Lanes, Memory, Modulus, WIDTH, Work, by_widest, primes_below,
};
use crate::exact::{Integer, Integers, Monomial, Polynomial, Polynomials, Rational};
use crate::interrupt::Supervision;
use crate::parallel::{par_map, threads};
use crate::series::FourierSeries;
use crate::series::fixed_width::{FixedWidth, ShortFraction};
use crate::series::waves::Wave;

type Symbols = Polynomials<Integers>;

/// Number of points up to which two words for each number are faster than primes: those that a
/// single run modulo a prime has room for. They are three to four times as fast with one symbol, half
/// as fast again with three to the second order, and as fast with two to the sixth.
const FEW: usize = WIDTH;

/// Number of points up to which one word is tried: with three symbols, ten points take two thirds of
/// the time of primes, and fifteen three quarters.
const MORE: usize = 2 * WIDTH;

/// Number of points times orders up to which one thread is faster than starting several.
const ALONE: usize = 200;

/// The expansion, to the order reached if it is interrupted. `None` if the equation has no symmetry
/// to use, no term of the first order, a determined amplitude or too many symbols, or if it is
/// interrupted before the first order; the recursion in the ring is used then.
pub(super) fn expand(
    force: &[ForceTerm<Symbols>],
    highest: usize,
    scheme: &Scheme,
    extent: ExpansionScope,
    supervision: Supervision,
) -> Option<SecularExpansion<Symbols>> {
    match scheme.amplitude {
        AmplitudeKind::Free => {
            by_widest(ExpandSymbols(force, highest, *scheme, extent, supervision))
        }
        AmplitudeKind::Determined => None,
    }
}

struct ExpandSymbols<'a>(&'a [ForceTerm<Symbols>], usize, Scheme, ExpansionScope, Supervision);

impl Work for ExpandSymbols<'_> {
    type Output = Option<SecularExpansion<Symbols>>;

    fn run<A: Arithmetic>(self, arithmetic: A) -> Self::Output {
        /// With more points this is as slow as polynomials.
        const MOST_POINTS: usize = 5000;
        /// Expansions to this order take no noticeable time.
        const SHORT: usize = 12;
        let Self(force, highest, scheme, extent, supervision) = self;
        let (terms, groups) = grouped(force)?;
        let base = groups.kinds.iter().position(|kind| kind.0 == 1)?;
        let weights: Vec<usize> = groups.kinds.iter().map(|kind| kind.0).collect();
        // Half of the orders cost a thirtieth of the work: they are kept in case it is interrupted
        // later.
        let halves =
            std::iter::successors(Some(highest), |order| (*order > SHORT).then_some(order / 2));
        let stages: Vec<usize> = halves.collect();
        let lower_set = |highest: usize| LowerSet::new(&weights, base, highest, MOST_POINTS);
        // The largest first: it says whether there are too many points.
        let mut largest = Some(lower_set(highest)?);
        let mut best: Option<SecularExpansion<Symbols>> = None;
        for stage in stages.into_iter().rev() {
            let lower_set = match largest.take_if(|_| stage == highest) {
                Some(largest) => largest,
                None => lower_set(stage)?,
            };
            let plan = Plan::new(&terms, None, stage, scheme, extent == ExpansionScope::Frequency)?;
            let points = lower_set.points.len();
            let by_one_word = || match points <= MORE && stage <= fixed_width::SHORT {
                true => short_orders::<i64>(&plan, &groups, &lower_set, extent),
                false => None,
            };
            let by_two_words = || match points <= FEW && stage <= fixed_width::LONG {
                true => short_orders::<i128>(&plan, &groups, &lower_set, extent),
                false => None,
            };
            let by_primes = || {
                let mut search = PrimeSearch {
                    arithmetic,
                    plan: &plan,
                    groups: &groups,
                    lower_set: &lower_set,
                    extent,
                    supervision,
                    primes: Box::new(primes_below(A::BITS, plan.circle())),
                    images: vec![],
                };
                search.orders()
            };
            let orders = by_one_word().or_else(by_two_words).or_else(by_primes)?;
            if best.as_ref().is_none_or(|best| best.frequency.len() < orders.len()) {
                let monomials = lower_set.monomials(&groups.kinds, base);
                best = Some(expansion(&plan, &orders, &monomials, extent));
            }
            if supervision.interrupt.is_requested() {
                break;
            }
        }
        // An expansion interrupted before the first correction is of no use.
        best.filter(|best| best.frequency.len() > highest.min(1))
    }
}

/// The symbols of the terms.
struct Groups {
    /// Power of the small parameter and product of symbols.
    kinds: Vec<(usize, Monomial)>,
    /// Index of the group of each term.
    of_terms: Vec<usize>,
}

/// The terms of the force with numbers for coefficients, and the group of symbols of each.
fn grouped(force: &[ForceTerm<Symbols>]) -> Option<(Vec<PlannedTerm>, Groups)> {
    let mut terms = Vec::new();
    let mut groups = Groups { kinds: vec![], of_terms: vec![] };
    for own in force {
        let (numerator, denominator) = own.coefficient.mean();
        for (monomial, number) in numerator.terms() {
            let kind = (own.order, monomial.clone());
            let known = groups.kinds.iter().position(|other| *other == kind);
            groups.of_terms.push(known.unwrap_or(groups.kinds.len()));
            if known.is_none() {
                groups.kinds.push(kind);
            }
            terms.push(PlannedTerm {
                order: own.order,
                position: own.position,
                velocity: own.velocity,
                coefficient: Rational::new(number.clone(), denominator.clone()),
            });
        }
    }
    (!terms.is_empty()).then_some((terms, groups))
}

/// The expansion modulo one prime, of all orders, or of the lower ones if it was interrupted: for
/// each order the plain residues of the coefficients, point by point; of the frequency, of its
/// square, and of the harmonics if they are wanted.
struct SymbolicImage {
    modulus: Modulus,
    orders: Vec<Vec<u64>>,
}

/// One order: the numbers as numerators over one denominator, point by point as in a
/// [`SymbolicImage`].
#[derive(Debug, PartialEq)]
struct SymbolicOrder {
    denominator: Integer,
    numerators: Vec<Integer>,
    /// Number of coefficients at each point.
    numbers: usize,
}

/// How many numbers an order has at each point.
fn numbers(plan: &Plan, extent: ExpansionScope, order: usize) -> usize {
    match extent {
        ExpansionScope::Frequency => 2,
        ExpansionScope::Motion => 2 + plan.harmonics(order),
    }
}

/// The numbers of all orders from their values at the points in one word or two each; `None` if one
/// does not fit.
fn short_orders<W: FixedWidth>(
    plan: &Plan,
    groups: &Groups,
    lower_set: &LowerSet,
    extent: ExpansionScope,
) -> Option<Vec<SymbolicOrder>> {
    let mut at_orders: Vec<Vec<ShortFraction<W>>> = vec![vec![]; plan.highest + 1];
    // The last points have the longest numbers: what does not fit is seen at once.
    let at_point = |point: &Vec<usize>| {
        let factor = |term: usize| match groups.of_terms[term] {
            group if lower_set.lines[group].is_empty() => 1,
            group => point[group] as i64,
        };
        fixed_width::with_factors::<W>(plan, extent, factor)
    };
    let expansions: Option<Vec<_>> = lower_set.points.iter().rev().map(at_point).collect();
    for (place, expansion) in expansions?.into_iter().rev().enumerate() {
        // The points of an order come after those of all lower orders.
        let first = lower_set.counts.partition_point(|count| *count <= place);
        for (order, values) in at_orders.iter_mut().enumerate().skip(first) {
            values.extend([expansion.frequency[order], expansion.frequency_squared[order]]);
            let displacement = expansion.displacement.get(order)?;
            for index in 2..numbers(plan, extent, order) {
                values.push(displacement.coefficient(index - 2)?);
            }
        }
    }
    let numbers_to_last = || (0..=plan.highest + 1).map(cast::<usize, W>);
    let nodes = numbers_to_last().map(|node| ShortFraction::new(node?, W::one()));
    let inverses = numbers_to_last().map(|node| ShortFraction::new(W::one(), node?.max(W::one())));
    let field = PointField {
        nodes: nodes.collect::<Option<_>>()?,
        inverses: inverses.collect::<Option<_>>()?,
        difference: |left: ShortFraction<W>, right: ShortFraction<W>| left.sum(right.negative()),
        product: ShortFraction::product,
    };
    let interpolated = |(order, mut values): (usize, Vec<ShortFraction<W>>)| {
        let numbers = numbers(plan, extent, order);
        lower_set.interpolate(&field, order, &mut values, numbers)?;
        let (denominator, numerators) = ShortFraction::over_common_denominator(&values)?;
        let numerators = numerators.into_iter().map(Into::into).collect();
        Some(SymbolicOrder { denominator: denominator.into(), numerators, numbers })
    };
    at_orders.into_iter().enumerate().map(interpolated).collect()
}

struct PrimeSearch<'a, A> {
    arithmetic: A,
    plan: &'a Plan<'a>,
    groups: &'a Groups,
    lower_set: &'a LowerSet,
    extent: ExpansionScope,
    supervision: Supervision,
    primes: Box<dyn Iterator<Item = u64> + Send + Sync>,
    images: Vec<SymbolicImage>,
}

impl<A: Arithmetic> PrimeSearch<'_, A> {
    fn numbers(&self, order: usize) -> usize {
        numbers(self.plan, self.extent, order)
    }

    /// The numbers of all orders at these points, unless the work is interrupted.
    fn values(&self, modulus: Modulus, points: &[Vec<usize>]) -> Option<Vec<Vec<u64>>> {
        let mut field = ResidueField::new(self.arithmetic, self.plan, &[modulus])?;
        let mut memory = Memory::zeroed(Recursion::<A>::entry_count(self.plan));
        let mut recursion =
            Recursion::new(self.arithmetic, self.plan, self.supervision.interrupt, memory.lanes());
        let own = std::mem::take(&mut field.coefficients);
        let mut coefficients = own.clone();
        let mut found = Vec::with_capacity(points.len());
        for eight in points.chunks(WIDTH) {
            for ((coefficient, own), group) in
                coefficients.iter_mut().zip(&own).zip(&self.groups.of_terms)
            {
                if !self.lower_set.lines[*group].is_empty() {
                    for ((lane, own), point) in coefficient.0.iter_mut().zip(own.0).zip(eight) {
                        *lane = modulus.product(own, modulus.small(point[*group] as i64));
                    }
                }
            }
            match recursion.expand(&mut field, &coefficients) {
                Some(()) => {}
                None if self.supervision.interrupt.is_requested() => break,
                None => return None,
            }
            for (lane, point) in eight.iter().enumerate() {
                let weight: usize = point
                    .iter()
                    .zip(&self.groups.kinds)
                    .map(|(exponent, kind)| exponent * kind.0)
                    .sum();
                let mut values = vec![];
                for order in weight..=self.plan.highest {
                    values.push(recursion.frequency()[order].0[lane]);
                    values.push(recursion.frequency_squared()[order].0[lane]);
                    if self.extent == ExpansionScope::Motion {
                        values.extend(recursion.displacement(order).map(|own| own.0[lane]));
                    }
                }
                found.push(values);
                self.supervision.progress.advance();
            }
        }
        Some(found)
    }

    /// The numbers at all points, in their order; if the work is interrupted, at the first ones
    /// that are complete.
    fn values_at_points(&self, modulus: Modulus) -> Option<Vec<Vec<u64>>> {
        let points = &self.lower_set.points;
        if points.len() * self.plan.highest > ALONE {
            /// Number of lots for each thread, so that none of them waits for long.
            const LOTS: usize = 4;
            let length = points.len().div_ceil(LOTS * threads()).next_multiple_of(WIDTH);
            let lots: Vec<_> = points.chunks(length).collect();
            let found = par_map(&lots, |points| self.values(modulus, points));
            let found: Option<Vec<Vec<Vec<u64>>>> = found.into_iter().collect();
            let mut values = Vec::with_capacity(points.len());
            for (own, points) in found?.into_iter().zip(lots) {
                let whole = own.len() == points.len();
                values.extend(own);
                if !whole {
                    break;
                }
            }
            return Some(values);
        }
        self.values(modulus, points)
    }

    fn image(&self, prime: u64) -> Option<SymbolicImage> {
        let modulus = Modulus::new(prime, A::RADIX);
        self.interpolated(modulus, &self.values_at_points(modulus)?)
    }

    /// The orders that are determined by these numbers at the first points.
    fn interpolated(&self, modulus: Modulus, at_points: &[Vec<u64>]) -> Option<SymbolicImage> {
        let highest = self.plan.highest;
        let nodes: Vec<u64> = (0..=highest as i64 + 1).map(|k| modulus.small(k)).collect();
        let mut inverses = nodes.clone();
        modulus.invert(&mut inverses[1..])?;
        let field = PointField {
            nodes,
            inverses,
            difference: |left, right| Some(modulus.difference(left, right)),
            product: |left, right| Some(modulus.product(left, right)),
        };
        // An order is complete when all its points are.
        let counts = &self.lower_set.counts;
        let reached = counts.partition_point(|count| *count <= at_points.len());
        let mut taken = vec![0; at_points.len()];
        let mut orders = Vec::with_capacity(reached);
        for (order, count) in counts.iter().enumerate().take(reached) {
            let numbers = self.numbers(order);
            let mut values = Vec::with_capacity(count * numbers);
            for (own, taken) in at_points.iter().zip(&mut taken).take(*count) {
                values.extend_from_slice(&own[*taken..*taken + numbers]);
                *taken += numbers;
            }
            self.lower_set.interpolate(&field, order, &mut values, numbers)?;
            values.iter_mut().for_each(|value| *value = modulus.plain(*value));
            orders.push(values);
        }
        Some(SymbolicImage { modulus, orders })
    }

    /// All orders, by as many primes as their fractions need; if the work is interrupted, the
    /// orders for which the primes suffice.
    fn orders(&mut self) -> Option<Vec<SymbolicOrder>> {
        /// Residues kept at once, half a gigabyte of them.
        const MOST_RESIDUES: usize = 1 << 26;
        let plan = self.plan;
        let mut orders = Vec::with_capacity(plan.highest + 1);
        let residues =
            (0..=plan.highest).map(|order| self.lower_set.counts[order] * self.numbers(order));
        let most = MOST_RESIDUES / residues.sum::<usize>().max(1);
        let mut count = 1;
        let mut stopped = false;
        while orders.len() <= plan.highest && !stopped {
            if count >= most {
                return None;
            }
            // One more prime serves as a test.
            let runs = (count + 1 - self.images.len()) * self.lower_set.points.len();
            self.supervision.progress.begin(runs);
            while self.images.len() <= count && !stopped {
                let prime = self.primes.next()?;
                let image = self.image(prime)?;
                stopped = image.orders.len() <= plan.highest;
                self.images.push(image);
            }
            let (test, images) = self.images.split_last()?;
            let moduli: Vec<Modulus> = images.iter().map(|image| image.modulus).collect();
            if moduli.is_empty() {
                break;
            }
            let remainders = Remainders::new(self.arithmetic, &moduli);
            let product: Integer =
                moduli.iter().map(|modulus| Integer::from(modulus.prime)).product();
            while let Some(in_test) = test.orders.get(orders.len()) {
                let order = orders.len();
                let Some(found) = fractions(images, &remainders, &product, order) else {
                    break;
                };
                let found = SymbolicOrder { numbers: self.numbers(order), ..found };
                if !found.agrees(&test.modulus, in_test) {
                    break;
                }
                orders.push(found);
            }
            count += count.div_ceil(2);
        }
        Some(orders)
    }
}

/// The numbers of an order as fractions; `None` if the primes are too few.
fn fractions<A: Arithmetic>(
    images: &[SymbolicImage],
    remainders: &Remainders<A>,
    product: &Integer,
    order: usize,
) -> Option<SymbolicOrder> {
    let mut denominator = Integer::one();
    let mut over: Vec<Integer> = vec![];
    let mut numerators = Vec::new();
    let mut weights: Vec<u64> = remainders.weights(|modulus| modulus.one).collect();
    let mut residues = vec![Lanes::default(); images.len()];
    let mut eight = ReconstructedIntegers::default();
    // Index of the first of the eight numbers that were lifted together over the present
    // denominator.
    let mut first = None;
    for index in 0..images[0].orders[order].len() {
        let start = *first.get_or_insert_with(|| {
            for (residues, image) in residues.iter_mut().zip(images) {
                let own = image.orders[order][index..].iter();
                residues.0.iter_mut().zip(own).for_each(|(lane, residue)| *lane = *residue);
            }
            remainders.lift(&mut residues, &weights, &mut eight);
            index
        });
        let number = eight.integer::<A>(index - start);
        if index - start == WIDTH - 1 {
            first = None;
        }
        let (numerator, more) = fraction(&number, product)?;
        if !more.is_one() {
            denominator *= more;
            if 2 * denominator.bits() > product.bits() {
                return None;
            }
            let scaled = |modulus: &Modulus| modulus.integer(&denominator);
            weights = remainders.weights(scaled).collect();
            first = None;
        }
        numerators.push(numerator);
        over.push(denominator.clone());
    }
    for (numerator, over) in numerators.iter_mut().zip(over) {
        *numerator *= &denominator / over;
    }
    Some(SymbolicOrder { denominator, numerators, numbers: 0 })
}

impl SymbolicOrder {
    /// Whether the numbers agree with their residues modulo a prime that was not used to find them.
    fn agrees(&self, modulus: &Modulus, plain: &[u64]) -> bool {
        let denominator = modulus.integer(&self.denominator);
        let pairs = self.numerators.iter().zip(plain);
        let mut pairs = pairs.map(|(numerator, residue)| {
            modulus.integer(numerator) == modulus.product(modulus.of_plain(*residue), denominator)
        });
        pairs.all(|agrees| agrees)
    }

    /// A number of the order as a polynomial over the [denominator](Self::denominator).
    fn polynomial(
        &self,
        number: usize,
        order: usize,
        (monomials, base): &(Vec<(Monomial, usize)>, Monomial),
    ) -> Polynomial<Integer> {
        let mut sum = Polynomial::zero();
        let numerators = self.numerators.iter().skip(number).step_by(self.numbers);
        for ((monomial, weight), numerator) in monomials.iter().zip(numerators) {
            if !numerator.is_zero() {
                let rest = base.power(i32::try_from(order - weight).unwrap_or(i32::MAX));
                sum.add_term(monomial.product(&rest), numerator.clone());
            }
        }
        sum
    }
}

/// The orders as series.
fn expansion(
    plan: &Plan,
    orders: &[SymbolicOrder],
    monomials: &(Vec<(Monomial, usize)>, Monomial),
    extent: ExpansionScope,
) -> SecularExpansion<Symbols> {
    let ring = Polynomials(Integers);
    let constant = |number: usize| -> Vec<FourierSeries<Symbols>> {
        let orders = orders.iter().enumerate();
        orders
            .map(|(order, own)| {
                let numerator = own.polynomial(number, order, monomials);
                FourierSeries::constant(ring, numerator).over(&own.denominator)
            })
            .collect()
    };
    let mut expansion = SecularExpansion {
        frequency: constant(0),
        frequency_squared: constant(1),
        displacement: vec![],
        amplitudes: vec![],
    };
    if extent == ExpansionScope::Motion {
        let series = |(order, own): (usize, &SymbolicOrder)| {
            let mut coefficients = Vec::new();
            for index in 0..plan.harmonics(order) {
                coefficients.resize(plan.harmonic(index), Polynomial::zero());
                coefficients.push(own.polynomial(2 + index, order, monomials));
            }
            let (cosine, sine) = match plan.wave(order) {
                Wave::Cosine => (coefficients, vec![]),
                Wave::Sine => (vec![], coefficients),
            };
            FourierSeries::in_lowest_terms(ring, own.denominator.clone(), cosine, sine)
        };
        expansion.displacement = orders.iter().enumerate().map(series).collect();
    }
    expansion
}

#[cfg(test)]
mod tests {
    use super::super::Detuning;
    use super::*;
    use crate::exact::residue::portable::Portable;
    use crate::solution::AmplitudeConvention;
    use crate::symbol::Symbol;

    fn letter(name: &str) -> Polynomial<Integer> {
        Polynomial::symbol(Symbol::new(name))
    }

    fn term(
        order: usize,
        position: u32,
        velocity: u32,
        (numerator, denominator): (Polynomial<Integer>, i64),
    ) -> ForceTerm<Symbols> {
        ForceTerm {
            order,
            position,
            velocity,
            coefficient: FourierSeries::constant(Polynomials(Integers), numerator)
                .over(&Integer::from(denominator)),
        }
    }

    /// Every number of the expansion is that of the recursion over polynomials.
    fn agrees(force: &[ForceTerm<Symbols>], highest: usize) {
        for normalisation in [AmplitudeConvention::Initial, AmplitudeConvention::FirstHarmonic] {
            for detuning in [Detuning::Acceleration, Detuning::Displacement] {
                let scheme = Scheme { normalisation, amplitude: AmplitudeKind::Free, detuning };
                let exact = super::super::expand(&Polynomials(Integers), force, highest, &scheme)
                    .expect("an expansion");
                let nobody = Supervision::default();
                let widest = expand(force, highest, &scheme, ExpansionScope::Motion, nobody)
                    .expect("the same by primes");
                let portable =
                    ExpandSymbols(force, highest, scheme, ExpansionScope::Motion, nobody)
                        .run(Portable);
                let alone = expand(force, highest, &scheme, ExpansionScope::Frequency, nobody)
                    .expect("the frequency");
                assert_eq!(alone.frequency_squared, exact.frequency_squared);
                assert_eq!(alone.frequency, exact.frequency);
                assert!(alone.displacement.is_empty());
                for found in [widest, portable.expect("the same by primes")] {
                    assert_eq!(found.frequency_squared, exact.frequency_squared);
                    assert_eq!(found.frequency, exact.frequency);
                    assert_eq!(found.displacement, exact.displacement);
                }
            }
        }
    }

    #[test]
    fn values_at_points_agree_with_polynomials() {
        let [a, b, c] = ["a", "b", "c"].map(letter);
        agrees(
            &[
                term(1, 2, 0, (a.clone(), 1)),
                term(1, 3, 0, (b.clone(), 3)),
                term(1, 5, 0, (c.clone(), 1)),
            ],
            4,
        );
        // Terms of several orders, with the velocity squared, the same letter twice, and a number.
        agrees(
            &[
                term(1, 3, 0, (a.clone(), 1)),
                term(2, 5, 0, (b.clone(), 2)),
                term(1, 1, 2, (a.clone(), -5)),
                term(2, 3, 2, (Polynomial::constant(Integer::from(7)), 4)),
            ],
            5,
        );
        // A sum for a coefficient, and a square.
        let mut sum = a.clone();
        sum.accumulate(&b.product(&b));
        for highest in [1, 2, 3, 4] {
            agrees(&[term(1, 3, 0, (sum.clone(), 1)), term(1, 5, 0, (b.clone(), 1))], highest);
        }
    }

    /// If the work is stopped after any number of points, the lower orders are available unchanged.
    #[test]
    fn the_first_points_are_enough_for_the_lower_orders() {
        let [a, b] = ["a", "b"].map(letter);
        let force =
            [term(1, 2, 0, (a.clone(), 1)), term(1, 3, 0, (b.clone(), 3)), term(2, 5, 0, (a, 7))];
        let scheme = Scheme {
            normalisation: AmplitudeConvention::Initial,
            amplitude: AmplitudeKind::Free,
            detuning: Detuning::Acceleration,
        };
        let (terms, groups) = grouped(&force).expect("terms");
        let weights: Vec<usize> = groups.kinds.iter().map(|kind| kind.0).collect();
        let lower_set = LowerSet::new(&weights, 0, 6, 1000).expect("few points");
        let plan = Plan::new(&terms, None, 6, scheme, false).expect("symmetry");
        let search = PrimeSearch {
            arithmetic: Portable,
            plan: &plan,
            groups: &groups,
            lower_set: &lower_set,
            extent: ExpansionScope::Motion,
            supervision: Supervision::default(),
            primes: Box::new(primes_below(30, plan.circle())),
            images: vec![],
        };
        let prime = primes_below(30, plan.circle()).next().expect("a prime");
        let modulus = Modulus::new(prime, 32);
        let values = search.values_at_points(modulus).expect("numbers");
        let all = search.interpolated(modulus, &values).expect("all orders");
        assert_eq!((values.len(), all.orders.len()), (lower_set.points.len(), 7));
        for count in 0..values.len() {
            let some = search.interpolated(modulus, &values[..count]).expect("some orders");
            let reached = some.orders.len();
            assert_eq!(some.orders, all.orders[..reached]);
            assert!(lower_set.counts[reached] > count, "{count} points are enough for more");
        }
    }

    /// The numbers in two words are those by primes, order by order, on both sides of the order at
    /// which the one takes the place of the other.
    #[test]
    fn two_words_and_primes_have_the_same_orders() {
        let [a, b, c] = ["a", "b", "c"].map(letter);
        let one = [term(1, 3, 0, (a.clone(), 1))];
        let two = [term(1, 2, 0, (a.clone(), 3)), term(1, 3, 0, (b.clone(), -2))];
        let three = [
            term(1, 3, 0, (a.clone(), 1)),
            term(2, 5, 0, (b.clone(), 7)),
            term(1, 1, 2, (c, -5)),
            term(1, 5, 0, (a, 9)),
        ];
        let scheme = Scheme {
            normalisation: AmplitudeConvention::Initial,
            amplitude: AmplitudeKind::Free,
            detuning: Detuning::Acceleration,
        };
        for (force, orders) in [(&one[..], 1..13), (&two[..], 1..8), (&three[..], 1..5)] {
            let (terms, groups) = grouped(force).expect("terms");
            let weights: Vec<usize> = groups.kinds.iter().map(|kind| kind.0).collect();
            for highest in orders {
                for extent in [ExpansionScope::Motion, ExpansionScope::Frequency] {
                    let lower_set = LowerSet::new(&weights, 0, highest, 1000).expect("few points");
                    let plan = Plan::new(&terms, None, highest, scheme, false).expect("symmetry");
                    let mut search = PrimeSearch {
                        arithmetic: Portable,
                        plan: &plan,
                        groups: &groups,
                        lower_set: &lower_set,
                        extent,
                        supervision: Supervision::default(),
                        primes: Box::new(primes_below(30, plan.circle())),
                        images: vec![],
                    };
                    let by_primes = search.orders().expect("all orders");
                    let by_words = short_orders::<i128>(&plan, &groups, &lower_set, extent)
                        .expect("short numbers");
                    assert_eq!(by_words, by_primes, "{force:?} to order {highest}, {extent:?}");
                    let by_one_word = short_orders::<i64>(&plan, &groups, &lower_set, extent);
                    assert!(by_one_word.is_some() || highest > 3, "{force:?} to order {highest}");
                    assert!(by_one_word.is_none_or(|own| own == by_primes), "{force:?}");
                }
            }
        }
    }

    #[test]
    fn numbers_too_long_for_two_words_are_found_by_primes() {
        let long = letter("a").product(&Polynomial::constant(Integer::from(1_u64 << 62)));
        let force = [term(1, 2, 0, (long.clone(), 3)), term(1, 3, 0, (long, 7))];
        agrees(&force, 3);
    }

    #[test]
    fn what_has_no_term_of_the_first_order_is_left_to_the_ring() {
        let scheme = Scheme {
            normalisation: AmplitudeConvention::Initial,
            amplitude: AmplitudeKind::Free,
            detuning: Detuning::Acceleration,
        };
        let terms = [term(2, 3, 0, (letter("a"), 1)), term(3, 5, 0, (letter("b"), 1))];
        assert!(
            expand(&terms, 6, &scheme, ExpansionScope::Motion, Supervision::default()).is_none()
        );
        let damped = [term(1, 0, 1, (letter("a"), 1)), term(1, 3, 0, (letter("b"), 1))];
        assert!(
            expand(&damped, 6, &scheme, ExpansionScope::Motion, Supervision::default()).is_none()
        );
    }
}

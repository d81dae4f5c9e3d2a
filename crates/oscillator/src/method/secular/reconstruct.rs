//! An exact expansion reconstructed from its images modulo many primes.
//!
//! References: J. von zur Gathen and J. Gerhard, *Modern Computer Algebra*, Cambridge 2013,
//! sections 5.4 (many small primes) and 5.10 (rational numbers).
//!
//! 1. A few primes give the first orders as fractions, and with them how the
//!    [denominators](super::denominators) grow. 2. The numerators over these denominators are whole
//!    numbers, and as many primes are run as they have digits. 3. Each numerator is
//!    [lifted](crate::exact::residue::remainder) and tested modulo one more prime, which was not
//!    used to find its digits.
//!
//! A wrong number would have to agree with the right one modulo that prime by chance, once in 2^50
//! (2^30 on processors without wide multiply-add). Primes are independent, and run on all threads
//! with one result.
//!
//! Memory: the residues of all coefficients, 8 bytes for each 50 binary digits of the result.

use num_integer::Integer as _;
use num_traits::{One, Zero};

use super::denominators::{Factored, Growth};
use super::fixed_width::Beginning;
use super::modular::{PrimeImage, Recursion};
use super::orders::{ExpansionOrder, expansion, motion_of_order, rational, short_expansion};
use super::plan::{Plan, PlannedTerm};
use super::{AmplitudeKind, ForceTerm, Scheme, SecularExpansion, fixed_width};
use crate::exact::residue::remainder::{ReconstructedIntegers, Remainders, fraction};
use crate::exact::residue::{
    Arithmetic, Lanes, Memory, Modulus, WIDTH, Work, by_widest, primes_below,
};
use crate::exact::{Integer, Integers, Rational};
use crate::interrupt::Supervision;
use crate::parallel::{par_map, threads};
use crate::series::fourier::fraction as in_lowest_terms;
use crate::series::waves::Wave;

/// The extent of an expansion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExpansionScope {
    /// Frequency and motion.
    Motion,
    /// The frequency alone, with half the digits and a part of the harmonics; the lists of
    /// everything else are empty.
    Frequency,
}

/// The expansion in integers of fixed width, or modulo many primes; `None` if the equation has no
/// symmetry to use, if the growth of the denominators is of no known kind, if the numbers are
/// short, or if no expansion exists. The recursion in the ring is used then.
pub fn expand(
    force: &[ForceTerm<Integers>],
    highest: usize,
    scheme: &Scheme,
    extent: ExpansionScope,
    supervision: Supervision,
) -> Option<SecularExpansion<Integers>> {
    /// Order below which integers are short enough.
    const LONG: usize = 8;
    let equation = SecularEquation::new(force, highest, *scheme, extent);
    let plan = equation.plan(highest)?;
    let has_slope =
        scheme.amplitude == AmplitudeKind::Determined && extent == ExpansionScope::Motion;
    let beginning = match fixed_width::beginning(&plan, extent, supervision.interrupt) {
        Beginning::OneWord(orders) => {
            let slope = orders.slope.filter(|_| has_slope).map(rational);
            return Some(short_expansion(&plan, &orders, slope.as_ref(), extent));
        }
        Beginning::TwoWords(orders) => orders,
    };
    let slope = match has_slope {
        false => None,
        true => Some(slope(force, scheme, &beginning)?),
    };
    if beginning.count > highest {
        return Some(short_expansion(&plan, &beginning, slope.as_ref(), extent));
    }
    let orders: Vec<ExpansionOrder> = (0..beginning.count)
        .map_while(|order| ExpansionOrder::of_short(&plan, order, &beginning))
        .collect();
    if highest < LONG {
        return None;
    }
    by_widest(ExpandByPrimes { equation: &equation, plan: &plan, slope, orders, supervision })
}

/// The derivative of the secular sine by the amplitude: if the amplitude is determined, its
/// condition has the same slope at every order.
fn slope(
    force: &[ForceTerm<Integers>],
    scheme: &Scheme,
    beginning: &fixed_width::FirstOrders,
) -> Option<Rational> {
    if let Some(slope) = beginning.slope {
        return Some(rational(slope));
    }
    let first = super::expand(&Integers, force, 1, scheme).ok()?;
    let (numerator, denominator) = first.amplitudes.first()?.slope.mean();
    Some(in_lowest_terms(&numerator, denominator))
}

/// Order up to which one thread is faster than starting several.
const ALONE: usize = 40;

/// The order to which long expansions are first derived to see how their denominators grow.
const GUESSED: usize = 32;

/// The equation to be expanded.
struct SecularEquation {
    terms: Vec<PlannedTerm>,
    /// The rate of a sine in addition to the terms.
    sine: Option<Rational>,
    scheme: Scheme,
    extent: ExpansionScope,
}

impl SecularEquation {
    fn new(
        force: &[ForceTerm<Integers>],
        highest: usize,
        scheme: Scheme,
        extent: ExpansionScope,
    ) -> Self {
        let terms = force.iter().map(|term| {
            let (numerator, denominator) = term.coefficient.mean();
            PlannedTerm {
                order: term.order,
                position: term.position,
                velocity: term.velocity,
                coefficient: in_lowest_terms(&numerator, denominator),
            }
        });
        let terms: Vec<PlannedTerm> = terms.collect();
        let (sine, terms) = match scheme.amplitude {
            AmplitudeKind::Free => super::sine::split(terms, highest),
            AmplitudeKind::Determined => (None, terms),
        };
        Self { terms, sine, scheme, extent }
    }

    fn plan(&self, highest: usize) -> Option<Plan<'_>> {
        let frequency_alone = self.extent == ExpansionScope::Frequency;
        Plan::new(&self.terms, self.sine.clone(), highest, self.scheme, frequency_alone)
    }
}

struct ExpandByPrimes<'a> {
    equation: &'a SecularEquation,
    plan: &'a Plan<'a>,
    slope: Option<Rational>,
    /// The first orders, in integers of fixed width.
    orders: Vec<ExpansionOrder>,
    supervision: Supervision,
}

impl Work for ExpandByPrimes<'_> {
    type Output = Option<SecularExpansion<Integers>>;

    fn run<A: Arithmetic>(self, arithmetic: A) -> Self::Output {
        /// Number of orders that show the growth of denominators.
        const SOME: usize = 8;
        let Self { equation, plan, slope, orders: short, supervision } = self;
        let extent = equation.extent;
        let beginning = match short.len() >= SOME {
            true => Some(FirstGuesses::from_orders(&short)?),
            false => None,
        };
        // A guess about the denominators that turns out wrong costs little where the order is low.
        let evident = beginning.as_ref().is_some_and(|beginning| beginning.is_power(plan));
        let (beginning, mut orders) = match plan.highest > 2 * GUESSED && !evident {
            false => (beginning, short),
            true => {
                let plan = equation.plan(GUESSED)?;
                let mut orders = short;
                let shorter =
                    Reconstruction::new(arithmetic, &plan, extent, Supervision::default());
                orders.extend(shorter.orders_from(orders.len(), beginning)?);
                (Some(FirstGuesses::from_orders(&orders)?), orders)
            }
        };
        let longer = Reconstruction::new(arithmetic, plan, extent, supervision);
        match longer.orders_from(orders.len(), beginning) {
            Some(others) => orders.extend(others),
            None if supervision.interrupt.is_requested() => {}
            None => return None,
        }
        (orders.len() > 1).then(|| expansion(orders, slope.as_ref(), extent))
    }
}

struct Reconstruction<'a, A> {
    arithmetic: A,
    plan: &'a Plan<'a>,
    extent: ExpansionScope,
    supervision: Supervision,
    primes: Vec<u64>,
    source: Box<dyn Iterator<Item = u64> + Send + Sync>,
    /// The expansions modulo the first primes, of all orders.
    first: Vec<PrimeImage>,
}

impl<'a, A: Arithmetic> Reconstruction<'a, A> {
    fn new(
        arithmetic: A,
        plan: &'a Plan<'a>,
        extent: ExpansionScope,
        supervision: Supervision,
    ) -> Self {
        Self {
            arithmetic,
            plan,
            extent,
            supervision,
            primes: vec![],
            source: Box::new(primes_below(A::BITS, plan.circle())),
            first: vec![],
        }
    }

    /// The orders from `first` on; those before are known.
    fn orders_from(
        mut self,
        first: usize,
        beginning: Option<FirstGuesses>,
    ) -> Option<Vec<ExpansionOrder>> {
        let beginning = match beginning {
            Some(beginning) => beginning,
            None => self.beginning()?,
        };
        let highest = self.plan.highest;
        let of_motion = |order| self.plan.largest_factor(order);
        let of_frequency = |order| self.plan.largest_factor_of_frequency(order);
        // If the motion is not wanted, the guess about its denominators does not matter.
        let guesses = match self.extent {
            ExpansionScope::Frequency => &Growth::ALL[..1],
            ExpansionScope::Motion => &Growth::ALL[..],
        };
        for growth in guesses {
            let motion = match self.extent {
                ExpansionScope::Frequency => Some(vec![Factored::default(); highest + 1]),
                ExpansionScope::Motion => {
                    growth.denominators(&beginning.motion.known, highest, &of_motion)
                }
            };
            let Some(motion) = motion else { continue };
            for growth in Growth::ALL {
                let frequency =
                    growth.denominators(&beginning.frequency.known, highest, &of_frequency);
                let lifted = frequency.and_then(|frequency| {
                    let bits = beginning.bits(&motion, &frequency);
                    self.lifted(first, &motion, &frequency, &bits)
                });
                if lifted.is_some() {
                    return lifted;
                }
            }
        }
        // The sizes may not go on as they did, so the second try assumes the largest growth.
        beginning.has_slopes().then(|| self.orders_from(first, Some(beginning.without_slopes())))?
    }

    /// The number of primes whose product has more than so many binary digits; `None` if there are
    /// not enough.
    fn primes_for(&mut self, bits: f64) -> Option<usize> {
        let mut product = 0.0;
        let mut count = 0;
        while product <= bits {
            if count == self.primes.len() {
                self.primes.push(self.source.next()?);
            }
            product += (self.primes[count] as f64).log2();
            count += 1;
        }
        Some(count)
    }

    /// Images of the primes from `self.first.len()` on, in eights, until there are `count`, each
    /// from the order on from which it is needed; fewer if the work is interrupted.
    fn images(
        &mut self,
        count: usize,
        wanted: &(dyn Fn(usize) -> usize + Sync),
    ) -> Option<Vec<PrimeImage>> {
        /// Number of blocks of eight primes that one thread runs in the same memory. After some
        /// such lots for each thread all threads are joined, so that an interrupted computation has
        /// no gaps.
        const LOT: usize = 8;
        const LOTS: usize = 4;
        let begun = self.first.len();
        let end = begun + count.saturating_sub(begun).next_multiple_of(WIDTH);
        while self.primes.len() < end {
            let Some(prime) = self.source.next() else {
                break;
            };
            self.primes.push(prime);
        }
        let places: Vec<usize> = (begun..end.min(self.primes.len())).collect();
        let this = &*self;
        let interrupt = this.supervision.interrupt;
        let lot = |places: &[usize]| -> Option<Vec<PrimeImage>> {
            let mut memory = Memory::zeroed(Recursion::<A>::entry_count(this.plan));
            let mut recursion =
                Recursion::new(this.arithmetic, this.plan, interrupt, memory.lanes());
            let mut images = Vec::with_capacity(places.len());
            for eight in places.chunks(WIDTH) {
                let primes = &this.primes[eight[0]..eight[0] + eight.len()];
                match recursion.images(primes, &|lane| wanted(eight[lane])) {
                    Some(own) => images.extend(own),
                    None if interrupt.is_requested() => break,
                    None => return None,
                }
                let counted = eight.iter().filter(|place| **place < count);
                counted.for_each(|_| this.supervision.progress.advance());
            }
            Some(images)
        };
        if this.plan.highest > ALONE {
            let threads = threads();
            let eights = places.len().div_ceil(WIDTH);
            let length = WIDTH * eights.div_ceil(threads).clamp(1, LOT);
            let mut images = Vec::with_capacity(places.len());
            for block in places.chunks(length * LOTS * threads) {
                let lots: Vec<&[usize]> = block.chunks(length).collect();
                let found: Option<Vec<Vec<PrimeImage>>> =
                    par_map(&lots, |places| lot(places)).into_iter().collect();
                for (own, places) in found?.into_iter().zip(lots) {
                    let whole = own.len() == places.len();
                    images.extend(own);
                    if !whole {
                        return Some(images);
                    }
                }
            }
            return Some(images);
        }
        lot(&places)
    }

    /// The first orders as fractions, by as many primes as they need.
    fn beginning(&mut self) -> Option<FirstGuesses> {
        /// Number of orders that show how denominators grow.
        const ORDERS: usize = 10;
        /// Largest number of primes for the first orders; more are needed only if the denominators
        /// have large factors.
        const MOST_PRIMES: usize = 100;
        let last = self.plan.highest.min(ORDERS);
        let mut beginning = FirstGuesses::default();
        let mut digits = if last > 5 { 200.0 } else { 100.0 };
        while beginning.frequency.known.len() <= last {
            let count = self.primes_for(digits)?;
            if count > MOST_PRIMES {
                return None;
            }
            let from = if self.extent == ExpansionScope::Motion { 0 } else { usize::MAX };
            let more = self.images(count, &|_| from)?;
            self.first.extend(more);
            if self.first.len() < count {
                return None;
            }
            digits *= 1.5;
            let images = &self.first[..count];
            let moduli: Vec<Modulus> = images.iter().map(|image| image.modulus).collect();
            let remainders = Remainders::new(self.arithmetic, &moduli);
            let product: Integer =
                moduli.iter().map(|modulus| Integer::from(modulus.prime)).product();
            let known = |count, number: &dyn Fn(&PrimeImage, usize) -> u64| {
                denominator_and_digits(images, count, &remainders, &product, number)
            };
            while beginning.frequency.known.len() <= last {
                let order = beginning.frequency.known.len();
                let count = match self.extent {
                    ExpansionScope::Motion => self.plan.harmonics(order),
                    ExpansionScope::Frequency => 0,
                };
                let motion =
                    known(count, &|image, index| image.displacement(self.plan, order)[index]);
                let frequency = known(2, &|image, index| match index {
                    0 => image.frequency[order],
                    _ => image.frequency_squared[order],
                });
                let (Some(motion), Some(frequency)) = (motion, frequency) else {
                    break;
                };
                beginning.motion.add(motion)?;
                beginning.frequency.add(frequency)?;
            }
        }
        Some(beginning)
    }

    /// The orders from `first` on over these denominators of motion and frequency, with numerators
    /// of so many binary digits; `None` if a number fails the test of the extra prime.
    fn lifted(
        &mut self,
        first: usize,
        motion: &[Factored],
        frequency: &[Factored],
        bits: &[f64],
    ) -> Option<Vec<ExpansionOrder>> {
        /// Residues kept at once, four gigabytes of them.
        const MOST_RESIDUES: usize = 1 << 29;
        let mut counts = Vec::with_capacity(bits.len());
        for bits in bits {
            counts.push(self.primes_for(*bits)?);
        }
        // Orders share the primes of the longest among their neighbours: the constants of a set of
        // primes are computed once, and the first primes run side by side anyway.
        let longest = counts.iter().copied().max()?;
        let mut least = 1;
        for count in &mut counts {
            let step = (*count / 8).next_power_of_two().max(WIDTH - 1);
            least = count.next_multiple_of(step).min(longest).max(least);
            *count = least;
        }
        if self.extent == ExpansionScope::Motion {
            let orders = counts.iter().enumerate();
            let kept: usize = orders.map(|(order, count)| self.plan.harmonics(order) * count).sum();
            if kept > MOST_RESIDUES {
                return None;
            }
        }
        let most = *counts.last()?;
        let extent = self.extent;
        let wanted = |place: usize| match extent {
            ExpansionScope::Motion => counts.partition_point(|count| *count < place).max(first),
            ExpansionScope::Frequency => usize::MAX,
        };
        self.supervision.progress.begin((most + 1).saturating_sub(self.first.len()));
        let images: Vec<PrimeImage> = self.images(most + 1, &wanted)?;
        let all: Vec<&PrimeImage> = self.first.iter().chain(&images).collect();
        let stopped = self.supervision.interrupt.is_requested();
        if all.len() <= most && !stopped {
            return None;
        }
        // If the work was interrupted, only the orders are kept for which the primes suffice.
        counts.truncate(counts.partition_point(|count| *count < all.len()));
        let mut groups: Vec<(usize, std::ops::Range<usize>)> = Vec::new();
        for (order, count) in counts.into_iter().enumerate().skip(first) {
            match groups.last_mut() {
                Some((own, orders)) if *own == count => orders.end = order + 1,
                _ => groups.push((count, order..order + 1)),
            }
        }
        let group = |(count, orders): &(usize, std::ops::Range<usize>)| {
            LiftOrders::new(self.arithmetic, self.plan, &all[..=*count]).orders(
                orders.clone(),
                motion,
                frequency,
            )
        };
        let lifted: Option<Vec<Vec<ExpansionOrder>>> = match self.plan.highest > ALONE {
            true => par_map(&groups, group).into_iter().collect(),
            false => groups.iter().map(group).collect(),
        };
        Some(lifted?.into_iter().flatten().collect())
    }
}

/// The common denominator of this many numbers and the digits that the largest has before the
/// point; `None` if the primes are too few.
fn denominator_and_digits<A: Arithmetic>(
    images: &[PrimeImage],
    count: usize,
    remainders: &Remainders<A>,
    product: &Integer,
    number: &dyn Fn(&PrimeImage, usize) -> u64,
) -> Option<(Integer, f64)> {
    let mut denominator = Integer::one();
    let mut largest = 0.0_f64;
    for index in 0..count {
        let scaled = |modulus: &Modulus| modulus.integer(&denominator);
        let weights: Vec<u64> = remainders.weights(scaled).collect();
        let residues = images.iter().map(|image| number(image, index));
        let residue = remainders.lift_one(residues, &weights);
        let (numerator, more) = fraction(&residue, product)?;
        denominator *= more;
        largest = largest.max(numerator.bits() as f64 - denominator.bits() as f64);
        if 2 * denominator.bits() > product.bits() {
            return None;
        }
    }
    Some((denominator, largest))
}

/// The first orders of motion and frequency.
#[derive(Default)]
struct FirstGuesses {
    motion: Guess,
    frequency: Guess,
}

impl FirstGuesses {
    /// The binary digits of the numerators of all orders over these denominators, and room for the
    /// factor before the growth.
    fn bits(&self, motion: &[Factored], frequency: &[Factored]) -> Vec<f64> {
        const ROOM: f64 = 24.0;
        let orders = motion.iter().zip(frequency).enumerate();
        orders
            .map(|(order, (motion, frequency))| {
                let motion = motion.bits() + self.motion.size(order);
                let frequency = frequency.bits() + self.frequency.size(order);
                motion.max(frequency) + ROOM
            })
            .collect()
    }

    fn has_slopes(&self) -> bool {
        self.motion.slope.is_some() || self.frequency.slope.is_some()
    }

    fn without_slopes(mut self) -> Self {
        (self.motion.slope, self.frequency.slope) = (None, None);
        self
    }

    /// Whether all denominators grow like powers, which a few orders show reliably.
    fn is_power(&self, plan: &Plan) -> bool {
        let fits = |guess: &Guess| {
            let divisors = |order| plan.largest_factor(order);
            guess.known.len() <= plan.highest
                && Growth::Power.denominators(&guess.known, plan.highest, &divisors).is_some()
        };
        [&self.motion, &self.frequency].into_iter().all(fits)
    }

    /// Guesses from the orders of a shorter expansion.
    fn from_orders(orders: &[ExpansionOrder]) -> Option<Self> {
        let mut beginning = Self::default();
        for order in orders {
            let denominator = order.displacement.mean().1;
            let longest = order.displacement.numerators().map(Integer::bits).max().unwrap_or(0);
            let size = longest as f64 - denominator.bits() as f64;
            beginning.motion.push(Factored::factorize(denominator)?, size);
            let both = [&order.frequency, &order.frequency_squared];
            let denominator = Factored::factorize(&both[0].denom().lcm(both[1].denom()))?;
            let sizes =
                both.map(|number| number.numer().bits() as f64 - number.denom().bits() as f64);
            beginning.frequency.push(denominator, sizes[0].max(sizes[1]));
        }
        Some(beginning)
    }
}

/// Denominators and sizes of further orders, guessed from the first ones.
#[derive(Default)]
struct Guess {
    /// The common denominators of the first orders.
    known: Vec<Factored>,
    /// Number of binary digits before the point of the largest number of each of them.
    sizes: Vec<f64>,
    /// Largest growth of that number with each order.
    growth: f64,
    /// Change of that number with each order in the second half of the known orders, if they are
    /// enough.
    slope: Option<f64>,
}

impl Guess {
    fn add(&mut self, (denominator, size): (Integer, f64)) -> Option<()> {
        self.push(Factored::factorize(&denominator)?, size);
        Some(())
    }

    fn push(&mut self, denominator: Factored, size: f64) {
        let order = self.known.len();
        self.growth = self.growth.max(size / order.max(1) as f64);
        self.known.push(denominator);
        self.sizes.push(size);
        let middle = order / 2;
        let slope = (size - self.sizes[middle]) / (order - middle).max(1) as f64;
        self.slope = (order >= Self::ENOUGH).then_some(slope);
    }

    /// Least number of orders from which a slope is inferred.
    const ENOUGH: usize = 8;

    /// Upper estimate of the binary digits before the point of the largest number of an order;
    /// negative if it is below one.
    fn size(&self, order: usize) -> f64 {
        /// Number of binary digits at each order for a slope that is not the same everywhere.
        const CAUTION: f64 = 0.5;
        let largest = self.growth * order as f64;
        let last = self.sizes.len().saturating_sub(1);
        match (self.slope, self.sizes.last()) {
            (Some(slope), Some(size)) if order >= last => {
                largest.min(size + (slope + CAUTION) * (order - last) as f64)
            }
            _ => largest,
        }
    }
}

/// The reconstruction of orders that share their primes.
struct LiftOrders<'a, A> {
    arithmetic: A,
    plan: &'a Plan<'a>,
    images: &'a [&'a PrimeImage],
    remainders: Remainders<A>,
    /// The image modulo the prime that serves only as a test.
    test: &'a PrimeImage,
    /// The residues of the powers of a digit modulo that prime.
    powers: Vec<u64>,
}

impl<'a, A: Arithmetic> LiftOrders<'a, A> {
    /// Prepares the reconstruction; the last of the images serves as the test.
    fn new(arithmetic: A, plan: &'a Plan<'a>, images: &'a [&'a PrimeImage]) -> Self {
        let (test, images) = images.split_last().expect("one image at least");
        let moduli: Vec<Modulus> = images.iter().map(|image| image.modulus).collect();
        let digit = test.modulus.residue(1 << A::DIGIT);
        let digits = (images.len() + 1) * A::BITS as usize / A::DIGIT as usize + 2 + WIDTH;
        let next = |power: &u64| Some(test.modulus.product(*power, digit));
        Self {
            arithmetic,
            plan,
            images,
            remainders: Remainders::new(arithmetic, &moduli),
            test,
            powers: std::iter::successors(Some(test.modulus.one), next).take(digits).collect(),
        }
    }

    fn orders(
        &self,
        orders: std::ops::Range<usize>,
        motion: &[Factored],
        frequency: &[Factored],
    ) -> Option<Vec<ExpansionOrder>> {
        // Factors that the guessed denominator had in excess at one order are mostly in excess at
        // the next as well.
        let mut excess = Factored::default();
        let (mut of_motion, mut of_frequency) = (None, None);
        let mut lifted = Vec::with_capacity(orders.len());
        for order in orders {
            let whole = &motion[order];
            let mut denominator = whole.quotient(&excess);
            let over = self.weighted_denominator(&denominator, of_motion.take());
            let mut displacement = self.displacement(order, of_motion.insert(over));
            if displacement.is_none() && !excess.is_one() {
                (excess, denominator) = (Factored::default(), whole.clone());
                displacement = self
                    .displacement(order, of_motion.insert(self.weighted_denominator(whole, None)));
            }
            let mut displacement = displacement?;
            let common = denominator.common(&displacement);
            if !common.is_one() {
                let divisor = common.value();
                displacement.iter_mut().for_each(|numerator| *numerator /= &divisor);
                excess = excess.product(&common);
            }
            let [frequency, frequency_squared] = match self.plan.wave(order) {
                // A sum of sines has no frequency to correct.
                Wave::Sine => [Rational::zero(), Rational::zero()],
                Wave::Cosine => {
                    let whole = &frequency[order];
                    let over = self.weighted_denominator(whole, of_frequency.take());
                    self.constants(order, whole, of_frequency.insert(over))?
                }
            };
            let denominator = denominator.quotient(&common);
            let first = match (self.plan.scheme.amplitude, self.plan.wave(order)) {
                (AmplitudeKind::Determined, Wave::Cosine) => {
                    displacement.get(self.plan.resonant()).cloned()
                }
                _ => None,
            };
            let (numerator, over_first) = denominator.lowest_terms(first.unwrap_or_default());
            lifted.push(ExpansionOrder {
                displacement: motion_of_order(self.plan, order, denominator.value(), displacement),
                first_harmonic: Rational::new_raw(numerator, over_first),
                frequency_squared,
                frequency,
            });
        }
        Some(lifted)
    }

    /// The frequency and its square at an order, over a denominator.
    fn constants(
        &self,
        order: usize,
        whole: &Factored,
        over: &WeightedDenominator,
    ) -> Option<[Rational; 2]> {
        let numerators = self.numbers(over, 2, |image, _, lanes| {
            (lanes.0[0], lanes.0[1]) = (image.frequency[order], image.frequency_squared[order]);
        });
        let constants = numerators?.into_iter().map(|numerator| {
            let (numerator, denominator) = whole.lowest_terms(numerator);
            Rational::new_raw(numerator, denominator)
        });
        constants.collect::<Vec<_>>().try_into().ok()
    }

    /// The numerators of the motion; empty if no prime keeps it.
    fn displacement(&self, order: usize, over: &WeightedDenominator) -> Option<Vec<Integer>> {
        let count = self.test.displacement(self.plan, order).len();
        self.numbers(over, count, |image, block, lanes| {
            let own = image.displacement(self.plan, order).iter().skip(block * WIDTH);
            lanes.0.iter_mut().zip(own).for_each(|(lane, residue)| *lane = *residue);
        })
    }

    /// The weighted denominator, from that of the last order if it divides this one.
    fn weighted_denominator(
        &self,
        denominator: &Factored,
        last: Option<WeightedDenominator>,
    ) -> WeightedDenominator {
        /// Number of primes for which a division each costs less than to prepare powers.
        const FEW: usize = 2 * WIDTH;
        if self.images.len() < FEW {
            let value = denominator.value();
            return WeightedDenominator {
                denominator: denominator.clone(),
                weights: self.remainders.weights(|modulus| modulus.integer(&value)).collect(),
                in_test: self.test.modulus.integer(&value),
            };
        }
        match last.filter(|last| last.denominator.quotient(denominator).is_one()) {
            Some(mut last) => {
                let ratio = denominator.quotient(&last.denominator).ladder();
                for (weight, image) in last.weights.iter_mut().zip(self.images) {
                    *weight = image.modulus.product(*weight, ratio.residue(&image.modulus));
                }
                let test = &self.test.modulus;
                WeightedDenominator {
                    denominator: denominator.clone(),
                    in_test: test.product(last.in_test, ratio.residue(test)),
                    ..last
                }
            }
            None => {
                let ladder = denominator.ladder();
                WeightedDenominator {
                    denominator: denominator.clone(),
                    weights: self.remainders.weights(|modulus| ladder.residue(modulus)).collect(),
                    in_test: ladder.residue(&self.test.modulus),
                }
            }
        }
    }

    /// The numerators of this many numbers over a denominator; `eight` writes a block of their
    /// residues.
    fn numbers(
        &self,
        over: &WeightedDenominator,
        count: usize,
        eight: impl Fn(&PrimeImage, usize, &mut Lanes),
    ) -> Option<Vec<Integer>> {
        let modulus = &self.test.modulus;
        let mut numerators = Vec::with_capacity(count);
        let mut residues = vec![Lanes::default(); self.images.len()];
        let mut numbers = ReconstructedIntegers::default();
        for block in 0..count.div_ceil(WIDTH) {
            for (own, image) in residues.iter_mut().zip(self.images) {
                eight(image, block, own);
            }
            self.remainders.lift(&mut residues, &over.weights, &mut numbers);
            let mut in_test = Lanes::default();
            eight(self.test, block, &mut in_test);
            let found = numbers.residues(self.arithmetic, modulus, &self.powers);
            let pairs = found.into_iter().zip(in_test.0).enumerate();
            for (place, (found, in_test)) in pairs.take(count - block * WIDTH) {
                if found != modulus.product(in_test, over.in_test) {
                    return None;
                }
                numerators.push(numbers.integer::<A>(place));
            }
        }
        Some(numerators)
    }
}

/// A denominator prepared for the reconstruction.
struct WeightedDenominator {
    denominator: Factored,
    /// The factors of the residues.
    weights: Vec<u64>,
    /// The residue of the denominator modulo the prime of the test.
    in_test: u64,
}

#[cfg(test)]
mod tests {
    use super::super::Detuning;
    use super::super::tests::term;
    use super::*;
    use crate::exact::residue::portable::Portable;
    use crate::series::FourierSeries;
    use crate::solution::AmplitudeConvention;

    /// Every number of the expansion, its steps included, is that of the recursion over whole
    /// numbers.
    fn agrees(force: &[ForceTerm<Integers>], highest: usize, amplitude: AmplitudeKind) {
        for normalisation in [AmplitudeConvention::Initial, AmplitudeConvention::FirstHarmonic] {
            for detuning in [Detuning::Acceleration, Detuning::Displacement] {
                let scheme = Scheme { normalisation, amplitude, detuning };
                let exact =
                    super::super::expand(&Integers, force, highest, &scheme).expect("an expansion");
                let widest = super::expand(
                    force,
                    highest,
                    &scheme,
                    ExpansionScope::Motion,
                    Supervision::default(),
                );
                let widest = widest.unwrap_or_else(|| panic!("{force:?} {scheme:?}"));
                let equation = SecularEquation::new(force, highest, scheme, ExpansionScope::Motion);
                let by_primes = ExpandByPrimes {
                    equation: &equation,
                    plan: &equation.plan(highest).expect("a symmetry"),
                    slope: slope(force, &scheme, &fixed_width::FirstOrders::default()),
                    orders: vec![],
                    supervision: Supervision::default(),
                };
                let portable = by_primes.run(Portable).expect("the same by primes");
                let alone = super::expand(
                    force,
                    highest,
                    &scheme,
                    ExpansionScope::Frequency,
                    Supervision::default(),
                );
                let alone = alone.unwrap_or_else(|| panic!("{force:?} {scheme:?}"));
                assert_eq!(alone.frequency_squared, exact.frequency_squared, "{scheme:?}");
                assert_eq!(alone.frequency, exact.frequency);
                assert!(alone.displacement.is_empty());
                for found in [widest, portable] {
                    assert_same(&found, &exact);
                }
                for low in [1, 2, 5] {
                    let exact =
                        super::super::expand(&Integers, force, low, &scheme).expect("an expansion");
                    let short = super::expand(
                        force,
                        low,
                        &scheme,
                        ExpansionScope::Motion,
                        Supervision::default(),
                    );
                    assert_same(&short.expect("numbers of a fixed width"), &exact);
                }
            }
        }
    }

    fn assert_same(found: &SecularExpansion<Integers>, exact: &SecularExpansion<Integers>) {
        assert_eq!(found.frequency_squared, exact.frequency_squared);
        assert_eq!(found.frequency, exact.frequency);
        assert_eq!(found.displacement, exact.displacement);
        assert_eq!(found.amplitudes.len(), exact.amplitudes.len());
        for (found, exact) in found.amplitudes.iter().zip(&exact.amplitudes) {
            assert_eq!(found.amplitude, exact.amplitude);
            assert_eq!(found.slope, exact.slope);
            assert_eq!(found.sine, exact.sine);
        }
    }

    #[test]
    fn primes_agree_with_whole_numbers() {
        let free = AmplitudeKind::Free;
        // Duffing; a quadratic force, whose motions have all harmonics; several orders, x x'^2
        // among them; the pendulum.
        agrees(&[term(1, 3, 0, (1, 1))], 24, free);
        agrees(&[term(1, 2, 0, (1, 1))], 13, free);
        agrees(&[term(1, 3, 0, (2, 7)), term(1, 1, 2, (1, 2)), term(2, 5, 0, (-1, 3))], 13, free);
        agrees(&[term(1, 2, 0, (3, 1)), term(2, 3, 0, (1, 5)), term(3, 0, 2, (1, 1))], 12, free);
        let mut coefficient = Rational::one();
        let mut sine: Vec<_> = (1..=12_i64)
            .map(|order| {
                let power = 2 * order;
                coefficient /= Rational::from_integer(Integer::from(-power * (power + 1)));
                let series = FourierSeries::constant(Integers, coefficient.numer().clone());
                ForceTerm {
                    coefficient: series.over(coefficient.denom()),
                    ..term(order as usize, power as u32 + 1, 0, (1, 1))
                }
            })
            .collect();
        agrees(&sine, 12, free);
        // The sine beside other terms, and the beginning of one.
        sine.push(term(1, 1, 2, (1, 2)));
        agrees(&sine, 10, free);
        agrees(&sine[..8], 12, free);
        let cycle = AmplitudeKind::Determined;
        // van der Pol, x = 2 y; Rayleigh; both with a nonlinear spring of the second order.
        agrees(&[term(1, 2, 1, (4, 1)), term(1, 0, 1, (-1, 1))], 16, cycle);
        agrees(&[term(1, 0, 3, (4, 3)), term(1, 0, 1, (-1, 1))], 13, cycle);
        agrees(&[term(1, 2, 1, (4, 1)), term(1, 0, 1, (-1, 1)), term(2, 3, 0, (1, 3))], 12, cycle);
    }

    /// An expansion in one word is the beginning of one in two, and that of one by primes, whichever
    /// order is the last that fits.
    #[test]
    fn the_end_of_a_width_leaves_no_trace() {
        let cases = [
            (vec![term(1, 3, 0, (1, 1))], AmplitudeKind::Free, 9..13),
            (vec![term(1, 3, 0, (1, 1))], AmplitudeKind::Free, 20..30),
            (vec![term(1, 2, 0, (2, 3))], AmplitudeKind::Free, 3..16),
            (vec![term(1, 2, 1, (4, 1)), term(1, 0, 1, (-1, 1))], AmplitudeKind::Determined, 3..14),
        ];
        for (force, amplitude, orders) in cases {
            let normalisation = AmplitudeConvention::Initial;
            let scheme = Scheme { normalisation, amplitude, detuning: Detuning::Acceleration };
            let expand = |highest: usize, extent: ExpansionScope| {
                expand(&force, highest, &scheme, extent, Supervision::default()).expect("numbers")
            };
            let long = expand(orders.end, ExpansionScope::Motion);
            for highest in orders {
                let found = expand(highest, ExpansionScope::Motion);
                let alone = expand(highest, ExpansionScope::Frequency);
                assert_eq!(found.displacement, long.displacement[..=highest], "{highest}");
                for (own, long) in found.amplitudes.iter().zip(&long.amplitudes) {
                    assert_eq!(own.amplitude, long.amplitude, "{highest}");
                    assert_eq!((&own.sine, &own.slope), (&long.sine, &long.slope), "{highest}");
                }
                for own in [&found, &alone] {
                    assert_eq!(own.frequency_squared, long.frequency_squared[..=highest]);
                    assert_eq!(own.frequency, long.frequency[..=highest], "{highest}");
                }
            }
        }
    }

    #[test]
    fn what_has_no_reversal_or_no_period_is_left_to_the_ring() {
        let scheme = |amplitude| Scheme {
            normalisation: AmplitudeConvention::Initial,
            amplitude,
            detuning: Detuning::Acceleration,
        };
        // A spring and damping at the same order: sines and cosines in every y_n.
        let mixed = [term(1, 2, 1, (4, 1)), term(1, 0, 1, (-1, 1)), term(1, 3, 0, (1, 1))];
        assert!(
            expand(
                &mixed,
                12,
                &scheme(AmplitudeKind::Determined),
                ExpansionScope::Motion,
                Supervision::default()
            )
            .is_none()
        );
        assert!(
            expand(
                &[term(1, 0, 1, (2, 1))],
                12,
                &scheme(AmplitudeKind::Free),
                ExpansionScope::Motion,
                Supervision::default()
            )
            .is_none()
        );
    }
}

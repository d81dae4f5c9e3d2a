//! An exact expansion put together from what many primes see of it.
//!
//! References: J. von zur Gathen and J. Gerhard, *Modern Computer Algebra*, Cambridge 2013, sections 5.4 (many small primes) and
//! 5.10 (rational numbers).
//!
//! 1. A few primes give the first orders as fractions, and with them how the [denominators](super::denominators) grow.
//! 2. The numerators over these denominators are whole numbers, and as many primes are run as they have digits.
//! 3. Each numerator is [lifted](crate::exact::residue::remainder) and tried modulo one prime more, which its digits know nothing of.
//!
//! A wrong number would have to agree with the right one modulo that prime by chance, once in 2^50 (2^30 on processors without
//! wide multiply-add). Primes are independent, and run on all threads with one result.
//!
//! Memory: the residues of all coefficients, 8 bytes for each 50 binary digits of the result.

use num_traits::{One, Zero};
#[cfg(feature = "parallel")]
use rayon::prelude::*;

use super::denominators::{Factored, Growth};
use super::modular::{self, Image, Plan, Term};
use super::{Amplitude, Expansion, ForceTerm, Scheme, SecularSine};
use crate::exact::residue::remainder::{Remainders, fraction};
use crate::exact::residue::{Arithmetic, Modulus, Work, by_widest, primes_below};
use crate::exact::{Integer, Integers, Rational};
use crate::series::FourierSeries;
use crate::series::fourier::fraction as in_lowest_terms;
use crate::series::waves::Wave;

/// The expansion by many primes; `None` where the equation has no symmetry to use, where the denominators grow in no known way,
/// and where there is none: the ring's own recursion answers then.
pub fn expand(force: &[ForceTerm<Integers>], highest: usize, scheme: &Scheme) -> Option<Expansion<Integers>> {
    by_widest(Expand(force, highest, *scheme))
}

struct Expand<'a>(&'a [ForceTerm<Integers>], usize, Scheme);

impl Work for Expand<'_> {
    type Output = Option<Expansion<Integers>>;

    fn by<A: Arithmetic>(self, arithmetic: A) -> Self::Output {
        let Self(force, highest, scheme) = self;
        let terms: Vec<Term> = force
            .iter()
            .map(|term| {
                let (numerator, denominator) = term.coefficient.mean();
                Term {
                    order: term.order,
                    position: term.position,
                    velocity: term.velocity,
                    coefficient: in_lowest_terms(&numerator, denominator),
                }
            })
            .collect();
        let plan = Plan::new(&terms, highest, scheme)?;
        // Where the amplitude is determined, its condition has the same slope at every order.
        let slope = match scheme.amplitude {
            Amplitude::Free => None,
            Amplitude::Determined => {
                let first = super::expand(&Integers, force, 1, &scheme).ok()?;
                Some(first.amplitudes.first()?.slope.clone())
            }
        };
        let orders = Reconstruction::new(arithmetic, &plan).orders()?;
        Some(expansion(&plan, orders, slope))
    }
}

/// One order of the result.
struct Order {
    /// Of all coefficients.
    denominator: Factored,
    displacement: Vec<Integer>,
    frequency_squared: Rational,
    frequency: Rational,
}

struct Reconstruction<'a, A> {
    arithmetic: A,
    plan: &'a Plan<'a>,
    primes: Vec<u64>,
    source: Box<dyn Iterator<Item = u64> + Send + Sync>,
    /// What the first primes see, of all orders.
    first: Vec<Image>,
}

impl<'a, A: Arithmetic> Reconstruction<'a, A> {
    fn new(arithmetic: A, plan: &'a Plan<'a>) -> Self {
        Self {
            arithmetic,
            plan,
            primes: vec![],
            source: Box::new(primes_below(A::BITS, plan.circle())),
            first: vec![],
        }
    }

    fn orders(mut self) -> Option<Vec<Order>> {
        let beginning = self.beginning()?;
        let known = &beginning.denominators;
        Growth::ALL.into_iter().find_map(|growth| {
            let largest_factor = |order| self.plan.largest_factor(order);
            let denominators = growth.denominators(known, self.plan.highest, &largest_factor)?;
            self.lifted(&denominators, beginning.growth)
        })
    }

    /// The number of primes whose product has more than so many binary digits; `None` where there are not enough.
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

    /// Images of the primes from `self.first.len()` up to `count`, each from the order on that it is wanted for.
    fn images(&self, count: usize, wanted: impl Fn(usize) -> usize + Sync) -> Option<Vec<Image>> {
        let image = |place: usize| modular::expand(self.arithmetic, self.plan, self.primes[place], wanted(place));
        let places = self.first.len()..count;
        #[cfg(feature = "parallel")]
        return places.into_par_iter().map(image).collect();
        #[cfg(not(feature = "parallel"))]
        places.map(image).collect()
    }

    /// The first orders as fractions, by as many primes as they need.
    fn beginning(&mut self) -> Option<Beginning> {
        /// Enough to see how denominators grow.
        const ORDERS: usize = 10;
        /// More than any such beginning needs: its denominators are no small numbers.
        const MOST_PRIMES: usize = 100;
        let last = self.plan.highest.min(ORDERS);
        let mut beginning = Beginning::default();
        let mut digits = if last > 5 { 200.0 } else { 100.0 };
        while beginning.denominators.len() <= last {
            let count = self.primes_for(digits)?;
            if count > MOST_PRIMES {
                return None;
            }
            let more = self.images(count, |_| 0)?;
            self.first.extend(more);
            digits *= 1.5;
            let moduli: Vec<Modulus> = self.first.iter().map(|image| image.modulus).collect();
            let remainders = Remainders::new(self.arithmetic, &moduli);
            let product: Integer = moduli.iter().map(|modulus| Integer::from(modulus.prime)).product();
            while let Some(known) = self.known(beginning.denominators.len(), &remainders, &product) {
                beginning.add(known)?;
                if beginning.denominators.len() > last {
                    break;
                }
            }
        }
        Some(beginning)
    }

    /// The common denominator of one order and the digits that its largest number has before the point; `None` where the primes
    /// are too few.
    fn known(&self, order: usize, remainders: &Remainders<A>, product: &Integer) -> Option<(Integer, f64)> {
        let mut denominator = Integer::one();
        let mut largest = f64::MIN;
        let coefficients = (0..self.plan.harmonics(order)).map(Some);
        for index in coefficients.chain([None]) {
            let number = |image: &Image| match index {
                Some(index) => image.displacement[order][index],
                None => image.frequency[order],
            };
            let scaled = |modulus: &Modulus| modulus.integer(&denominator);
            let weights: Vec<u64> = remainders.weights(scaled).collect();
            let residue = remainders
                .lift(&weighted(&self.first, &weights, number))
                .to_integer::<A>();
            let positive = if residue < Integer::zero() {
                residue + product
            } else {
                residue
            };
            let (numerator, more) = fraction(&positive, product)?;
            denominator *= more;
            if !numerator.is_zero() {
                // The digits of the numerator count only with this denominator; the next ones may be longer by theirs.
                largest = largest.max(numerator.bits() as f64 - denominator.bits() as f64);
            }
            if 2 * denominator.bits() > product.bits() {
                return None;
            }
        }
        Some((denominator, largest))
    }

    /// All orders over these denominators; `None` where a number fails the test of the extra prime.
    fn lifted(&mut self, denominators: &[Factored], growth: f64) -> Option<Vec<Order>> {
        /// Digits beside those of denominator and size, for the factor before the growth.
        const ROOM: f64 = 24.0;
        let mut counts = Vec::with_capacity(denominators.len());
        for (order, denominator) in denominators.iter().enumerate() {
            let count = self.primes_for(denominator.bits() + growth * order as f64 + ROOM)?;
            // Orders share the primes of the longest among their neighbours: what a set of primes needs is computed once.
            let step = (count / 8).next_power_of_two();
            counts.push(count.next_multiple_of(step).max(counts.last().copied().unwrap_or(1)));
        }
        let most = *counts.last()?;
        while self.primes.len() <= most {
            self.primes.push(self.source.next()?);
        }
        let wanted = |place: usize| counts.partition_point(|count| *count < place);
        let images: Vec<Image> = self.images(most + 1, wanted)?;
        let all: Vec<&Image> = self.first.iter().chain(&images).collect();
        let mut groups: Vec<(usize, std::ops::Range<usize>)> = Vec::new();
        for (order, count) in counts.into_iter().enumerate() {
            match groups.last_mut() {
                Some((own, orders)) if *own == count => orders.end = order + 1,
                _ => groups.push((count, order..order + 1)),
            }
        }
        let group = |(count, orders): (usize, std::ops::Range<usize>)| {
            Lift::new(self.arithmetic, self.plan, &all[..=count]).orders(orders, denominators)
        };
        #[cfg(feature = "parallel")]
        let lifted: Option<Vec<Vec<Order>>> = groups.into_par_iter().map(group).collect();
        #[cfg(not(feature = "parallel"))]
        let lifted: Option<Vec<Vec<Order>>> = groups.into_iter().map(group).collect();
        Some(lifted?.into_iter().flatten().collect())
    }
}

/// The first orders.
#[derive(Default)]
struct Beginning {
    denominators: Vec<Factored>,
    /// By how many binary digits the largest number grows with each order, at most.
    growth: f64,
}

impl Beginning {
    fn add(&mut self, (denominator, size): (Integer, f64)) -> Option<()> {
        let order = self.denominators.len();
        self.growth = self.growth.max(size / order.max(1) as f64);
        self.denominators.push(Factored::of(&denominator)?);
        Some(())
    }
}

/// The residues of one number, each times its weight.
fn weighted<'a>(
    images: impl IntoIterator<Item = &'a Image>,
    weights: &[u64],
    number: impl Fn(&Image) -> u64,
) -> Vec<u64> {
    let pairs = images.into_iter().zip(weights);
    pairs
        .map(|(image, weight)| image.modulus.product(number(image), *weight))
        .collect()
}

/// The way back for orders that share their primes.
struct Lift<'a, A> {
    plan: &'a Plan<'a>,
    images: &'a [&'a Image],
    remainders: Remainders<A>,
    /// The prime that only tests.
    test: &'a Image,
    /// The residues of the powers of a digit modulo that prime.
    powers: Vec<u64>,
}

impl<'a, A: Arithmetic> Lift<'a, A> {
    /// The last of the images is the one that tests.
    fn new(arithmetic: A, plan: &'a Plan<'a>, images: &'a [&'a Image]) -> Self {
        let (test, images) = images.split_last().expect("one image at least");
        let moduli: Vec<Modulus> = images.iter().map(|image| image.modulus).collect();
        let digit = test.modulus.residue(1 << A::DIGIT);
        let digits = (images.len() + 1) * A::BITS as usize / A::DIGIT as usize + 2;
        let next = |power: &u64| Some(test.modulus.product(*power, digit));
        Self {
            plan,
            images,
            remainders: Remainders::new(arithmetic, &moduli),
            test,
            powers: std::iter::successors(Some(test.modulus.one), next)
                .take(digits)
                .collect(),
        }
    }

    fn orders(&self, orders: std::ops::Range<usize>, denominators: &[Factored]) -> Option<Vec<Order>> {
        // What the guessed denominators had too much of in the order before they mostly have in the next as well.
        let mut excess = Factored::default();
        let mut lifted = Vec::with_capacity(orders.len());
        for order in orders {
            let whole = &denominators[order];
            let over_whole = self.over(whole);
            let mut denominator = whole.over(&excess);
            let mut displacement = match excess.is_one() {
                true => None,
                false => self.displacement(order, &self.over(&denominator)),
            };
            if displacement.is_none() {
                (excess, denominator) = (Factored::default(), whole.clone());
                displacement = self.displacement(order, &over_whole);
            }
            let mut displacement = displacement?;
            let common = denominator.common(&displacement);
            if !common.is_one() {
                let divisor = common.value();
                displacement.iter_mut().for_each(|numerator| *numerator /= &divisor);
                excess = excess.times(&common);
            }
            let constant = |number: &dyn Fn(&Image) -> u64| -> Option<Rational> {
                let numerators = self.numbers(&over_whole, 1, |image, _| number(image))?;
                let numerator = numerators.into_iter().next()?;
                let (numerator, denominator) = whole.lowest_terms(numerator);
                Some(Rational::new_raw(numerator, denominator))
            };
            lifted.push(Order {
                denominator: denominator.over(&common),
                displacement,
                frequency_squared: constant(&|image| image.frequency_squared[order])?,
                frequency: constant(&|image| image.frequency[order])?,
            });
        }
        Some(lifted)
    }

    fn displacement(&self, order: usize, over: &Over) -> Option<Vec<Integer>> {
        let count = self.plan.harmonics(order);
        self.numbers(over, count, |image, index| image.displacement[order][index])
    }

    fn over(&self, denominator: &Factored) -> Over {
        Over {
            weights: self
                .remainders
                .weights(|modulus| denominator.residue(modulus))
                .collect(),
            in_test: denominator.residue(&self.test.modulus),
        }
    }

    /// The numerators of so many numbers over a denominator.
    fn numbers(&self, over: &Over, count: usize, number: impl Fn(&Image, usize) -> u64) -> Option<Vec<Integer>> {
        let modulus = &self.test.modulus;
        let mut numerators = Vec::with_capacity(count);
        for index in 0..count {
            let images = self.images.iter().copied();
            let digits = self
                .remainders
                .lift(&weighted(images, &over.weights, |image| number(image, index)));
            let expected = modulus.product(modulus.of_plain(number(self.test, index)), over.in_test);
            if digits.residue(modulus, &self.powers) != expected {
                return None;
            }
            numerators.push(digits.to_integer::<A>());
        }
        Some(numerators)
    }
}

/// A denominator, as the way back needs it.
struct Over {
    /// By which residues are multiplied.
    weights: Vec<u64>,
    /// Its residue modulo the prime that tests.
    in_test: u64,
}

/// The orders as series; `slope` is that of the secular sine in the amplitude.
fn expansion(plan: &Plan, orders: Vec<Order>, slope: Option<FourierSeries<Integers>>) -> Expansion<Integers> {
    let constant = |value: &Rational| match value.is_zero() {
        true => FourierSeries::zero(Integers),
        false => FourierSeries::in_lowest_terms(Integers, value.denom().clone(), vec![value.numer().clone()], vec![]),
    };
    let series = |order: usize, denominator: &Factored, numerators: Vec<Integer>| {
        let mut coefficients = Vec::new();
        for (index, numerator) in numerators.into_iter().enumerate() {
            coefficients.resize(plan.harmonic(index), Integer::zero());
            coefficients.push(numerator);
        }
        let (cosine, sine) = match plan.wave(order) {
            Wave::Cosine => (coefficients, vec![]),
            Wave::Sine => (vec![], coefficients),
        };
        FourierSeries::in_lowest_terms(Integers, denominator.value(), cosine, sine)
    };
    let frequency_squared: Vec<_> = orders.iter().map(|order| constant(&order.frequency_squared)).collect();
    let frequency = orders.iter().map(|order| constant(&order.frequency)).collect();
    // The first harmonic of a limit cycle is the amplitude that its secular sine has fixed.
    let amplitudes = slope.map_or_else(Vec::new, |slope| {
        let (numerator, denominator) = slope.mean();
        let rate = in_lowest_terms(&numerator, denominator);
        let secular_sine = |(order, own): (usize, &Order)| {
            let first = match plan.wave(order) {
                Wave::Cosine => own.displacement.get(plan.resonant()).cloned().unwrap_or_default(),
                Wave::Sine => Integer::zero(),
            };
            let (numerator, denominator) = own.denominator.lowest_terms(first);
            let amplitude = Rational::new_raw(numerator, denominator);
            SecularSine {
                sine: constant(&-(&amplitude * &rate)),
                slope: slope.clone(),
                amplitude: constant(&amplitude),
            }
        };
        orders.iter().enumerate().skip(1).map(secular_sine).collect()
    });
    Expansion {
        removed: orders
            .iter()
            .skip(1)
            .map(|order| constant(&-&order.frequency_squared))
            .collect(),
        amplitudes,
        frequency_squared,
        frequency,
        displacement: orders
            .into_iter()
            .enumerate()
            .map(|(order, own)| series(order, &own.denominator, own.displacement))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Detuning;
    use super::*;
    use crate::exact::residue::portable::Portable;
    use crate::solution::AmplitudeConvention;

    fn term(order: usize, position: u32, velocity: u32, value: (i64, i64)) -> ForceTerm<Integers> {
        let coefficient = FourierSeries::integer(Integers, value.0).divided_by(value.1);
        ForceTerm {
            order,
            position,
            velocity,
            coefficient,
        }
    }

    /// Every number of the expansion, its steps included, is that of the recursion over whole numbers.
    fn agrees(force: &[ForceTerm<Integers>], highest: usize, amplitude: Amplitude) {
        for normalisation in [AmplitudeConvention::Initial, AmplitudeConvention::FirstHarmonic] {
            for detuning in [Detuning::Acceleration, Detuning::Displacement] {
                let scheme = Scheme {
                    normalisation,
                    amplitude,
                    detuning,
                };
                let exact = super::super::expand(&Integers, force, highest, &scheme).expect("an expansion");
                let widest = by_widest(Expand(force, highest, scheme)).expect("the same by primes");
                let portable = Expand(force, highest, scheme)
                    .by(Portable::new())
                    .expect("the same by primes");
                for found in [widest, portable] {
                    assert_eq!(found.frequency_squared, exact.frequency_squared, "{scheme:?}");
                    assert_eq!(found.frequency, exact.frequency);
                    assert_eq!(found.displacement, exact.displacement);
                    assert_eq!(found.removed, exact.removed);
                    assert_eq!(found.amplitudes.len(), exact.amplitudes.len());
                    for (found, exact) in found.amplitudes.iter().zip(&exact.amplitudes) {
                        assert_eq!(found.amplitude, exact.amplitude);
                        assert_eq!(found.slope, exact.slope);
                        assert_eq!(found.sine, exact.sine);
                    }
                }
            }
        }
    }

    #[test]
    fn primes_agree_with_whole_numbers() {
        let free = Amplitude::Free;
        // Duffing; a quadratic force, whose motions have all harmonics; several orders, x x'^2 among them; the pendulum.
        agrees(&[term(1, 3, 0, (1, 1))], 24, free);
        agrees(&[term(1, 2, 0, (1, 1))], 13, free);
        agrees(
            &[term(1, 3, 0, (2, 7)), term(1, 1, 2, (1, 2)), term(2, 5, 0, (-1, 3))],
            13,
            free,
        );
        agrees(
            &[term(1, 2, 0, (3, 1)), term(2, 3, 0, (1, 5)), term(3, 0, 2, (1, 1))],
            12,
            free,
        );
        let mut factorial = 1;
        let sine: Vec<_> = (1..9)
            .map(|order| {
                let power = 2 * order;
                factorial *= -power * (power + 1);
                term(order as usize, power as u32 + 1, 0, (1, factorial))
            })
            .collect();
        agrees(&sine, 12, free);
        let cycle = Amplitude::Determined;
        // van der Pol, x = 2 y; Rayleigh; both with a nonlinear spring of the second order.
        agrees(&[term(1, 2, 1, (4, 1)), term(1, 0, 1, (-1, 1))], 16, cycle);
        agrees(&[term(1, 0, 3, (4, 3)), term(1, 0, 1, (-1, 1))], 13, cycle);
        agrees(
            &[term(1, 2, 1, (4, 1)), term(1, 0, 1, (-1, 1)), term(2, 3, 0, (1, 3))],
            12,
            cycle,
        );
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
        assert!(expand(&mixed, 12, &scheme(Amplitude::Determined)).is_none());
        assert!(expand(&[term(1, 0, 1, (2, 1))], 12, &scheme(Amplitude::Free)).is_none());
    }
}

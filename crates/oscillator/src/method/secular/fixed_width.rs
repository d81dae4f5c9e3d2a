//! The first orders of an expansion in integers of fixed width, as far as they do not overflow.
//!
//! The recursion of the head of [the module](super) on [short series](crate::series::fixed_width),
//! whose symmetries are those of the [plan](super::modular) for primes. Low orders need no more
//! than this, and long expansions estimate the growth of their denominators from it.
//!
//! Cost: for every product `O(N^2 K^2)` multiplications of words to order `N` with `K` harmonics;
//! two words hold Duffing's equation to order 25.

use super::plan::{Plan, PlannedTerm};
use super::{AmplitudeKind, Detuning, ExpansionScope};
use crate::exact::residue::sums::Product;
use crate::interrupt::Interrupt;
use crate::series::fixed_width::{
    HarmonicParity, ShortFraction, ShortSeries, combination, convolution, square,
};
use crate::series::waves::Wave;
use crate::solution::AmplitudeConvention;
use num_traits::ToPrimitive;

/// One order.
pub(super) struct FixedWidthOrder {
    pub displacement: ShortSeries,
    /// `W_n` and `omega_n`.
    pub frequency_squared: ShortFraction,
    pub frequency: ShortFraction,
}

/// The first orders of an expansion in integers of fixed width.
#[derive(Default)]
pub(super) struct FirstOrders {
    /// The orders from zero on; fewer than asked for if a number does not fit.
    pub orders: Vec<FixedWidthOrder>,
    /// The derivative of the secular sine in the amplitude, where that is determined.
    pub slope: Option<ShortFraction>,
}

/// Order beyond which two words are too short.
pub(super) const LONG: usize = 28;

/// The orders up to the highest of the plan, or as many as fit; of a long expansion, and of one that
/// will not fit, only as many as show how its denominators grow.
pub(super) fn beginning(plan: &Plan, extent: ExpansionScope, interrupt: Interrupt) -> FirstOrders {
    /// Number of orders that are computed of a long expansion.
    const ENOUGH: usize = 16;
    /// Number of orders that show whether the last one will fit, and how denominators grow.
    const FEW: usize = 10;
    let last = if plan.highest > LONG { ENOUGH } else { plan.highest };
    // Before its order a term leaves no trace in the denominators.
    let furthest = plan.terms.iter().map(|term| term.order).max().unwrap_or(0);
    let few = FEW.max(furthest);
    let mut beginning = FirstOrders::default();
    if let Some(mut recursion) = Recursion::new(plan, extent, |_| 1) {
        while recursion.complete <= last && !interrupt.is_requested() {
            if recursion.next_order().is_none()
                || (recursion.complete == few + 1 && !recursion.may_fit(last))
            {
                break;
            }
        }
        beginning.slope = recursion.variation.as_ref().map(|variation| variation.slope);
        beginning.orders = recursion.orders();
    }
    beginning
}

/// The expansion to the highest order of a plan, with the coefficient of each term multiplied by a
/// factor; `None` if a number does not fit.
pub(super) fn with_factors(
    plan: &Plan,
    extent: ExpansionScope,
    factor: impl Fn(usize) -> i128,
) -> Option<Vec<FixedWidthOrder>> {
    let mut recursion = Recursion::new(plan, extent, factor)?;
    while recursion.complete <= plan.highest {
        recursion.next_order()?;
    }
    Some(recursion.orders())
}

struct Recursion<'a> {
    plan: &'a Plan<'a>,
    extent: ExpansionScope,
    /// The terms with their coefficients, each divided by the power of which the term is a
    /// derivative; `None` for one that overflows.
    terms: Vec<(&'a PlannedTerm, Option<(i128, i128)>)>,
    /// The tables of the plan, an entry for each order; the first is the motion.
    tables: Vec<Vec<ShortSeries>>,
    detuned: Vec<ShortSeries>,
    derived: Vec<ShortSeries>,
    /// The derivative of all terms with one velocity at each order, where there are any.
    damped: Vec<Option<ShortSeries>>,
    frequency_squared: Vec<ShortFraction>,
    frequency: Vec<ShortFraction>,
    /// A sine in addition to the terms.
    sine: Option<Sine>,
    variation: Option<Variation>,
    /// Number of orders whose amplitudes are known, too.
    complete: usize,
}

/// Derivatives of all quantities by the amplitude of `y_0`, for limit cycles.
struct Variation {
    tables: Vec<ShortSeries>,
    right_side: ShortSeries,
    damped: Option<ShortSeries>,
    slope: ShortFraction,
}

impl<'a> Recursion<'a> {
    /// A recursion in which the coefficient of each term is multiplied by a factor.
    fn new(
        plan: &'a Plan<'a>,
        extent: ExpansionScope,
        factor: impl Fn(usize) -> i128,
    ) -> Option<Self> {
        let coefficient = |place: usize, term: &PlannedTerm, derivative: bool| {
            let power = if derivative { i128::from(term.position) + 1 } else { 1 };
            let denominator = term.coefficient.denom().to_i128()?.checked_mul(power)?;
            let numerator = term.coefficient.numer().to_i128()?.checked_mul(factor(place))?;
            Some((numerator, denominator))
        };
        let terms = plan.terms.iter().zip(&plan.of_terms).enumerate();
        let orders = LONG.min(plan.highest) + 2;
        let list = || Vec::with_capacity(orders);
        let mut recursion = Self {
            plan,
            extent,
            terms: terms
                .map(|(place, (term, (_, derivative)))| {
                    (term, coefficient(place, term, *derivative))
                })
                .collect(),
            sine: match &plan.sine {
                Some((_, rate)) => {
                    Some(Sine::new((rate.numer().to_i128()?, rate.denom().to_i128()?)))
                }
                None => None,
            },
            tables: (0..plan.tables).map(|_| list()).collect(),
            detuned: list(),
            derived: vec![],
            damped: vec![None],
            frequency_squared: Vec::with_capacity(orders),
            frequency: Vec::with_capacity(orders),
            variation: None,
            complete: 0,
        };
        recursion.frequency_squared.push(ShortFraction::ONE);
        recursion.frequency.push(ShortFraction::ONE);
        let mut start = vec![0; plan.resonant() + 1];
        start[plan.resonant()] = 1;
        let start = ShortSeries::new(Wave::Cosine, recursion.harmonics(), 1, start)?;
        recursion.push_displacement(0, start)?;
        match plan.scheme.amplitude {
            AmplitudeKind::Free => recursion.complete = 1,
            AmplitudeKind::Determined => recursion.variation = Some(recursion.variation()?),
        }
        Some(recursion)
    }

    /// Whether the denominators of an order will fit if they go on growing as they did.
    fn may_fit(&self, order: usize) -> bool {
        /// Number of binary digits that fit.
        const DIGITS: f64 = 126.0;
        let digits = |order: usize| (self.tables[0][order].denominator() as f64).log2();
        let (last, middle) = (self.complete - 1, (self.complete - 1) / 2);
        let rate = (digits(last) - digits(middle)) / (last - middle).max(1) as f64;
        digits(last) + rate * order.saturating_sub(last) as f64 <= DIGITS
    }

    fn harmonics(&self) -> HarmonicParity {
        match self.plan.half_wave {
            true => HarmonicParity::Odd,
            false => HarmonicParity::All,
        }
    }

    /// Returns the orders that are complete.
    fn orders(mut self) -> Vec<FixedWidthOrder> {
        let numbers = self.frequency_squared.into_iter().zip(self.frequency);
        let orders = self.tables.swap_remove(0).into_iter().zip(numbers).take(self.complete);
        orders
            .map(|(displacement, (frequency_squared, frequency))| FixedWidthOrder {
                displacement,
                frequency_squared,
                frequency,
            })
            .collect()
    }

    /// Solves the order after those that are known; the last one of a limit cycle only fixes the
    /// amplitude of the order before. `None` if a number overflows, or if a secular sine remains.
    fn next_order(&mut self) -> Option<()> {
        let (plan, order) = (self.plan, self.tables[0].len());
        let mut right_side = self.right_side(order)?;
        if self.variation.is_some() {
            if order > 1 {
                right_side = self.fix_amplitude(order, right_side)?;
            }
            self.complete = order;
            if order > plan.highest {
                self.complete = plan.highest + 1;
                return Some(());
            }
        }
        let resonance = right_side.coefficient(plan.resonant())?;
        let square = match right_side.wave {
            Wave::Sine if !resonance.is_zero() => return None,
            Wave::Sine => ShortFraction::ZERO,
            Wave::Cosine => resonance.negative(),
        };
        let frequency = self.frequency(order, square)?;
        self.frequency_squared.push(square);
        self.frequency.push(frequency);
        if self.variation.is_none()
            && self.extent == ExpansionScope::Frequency
            && order == plan.highest
        {
            // Nothing that is wanted depends on the last motion.
            let none = ShortSeries::new(right_side.wave, self.harmonics(), 1, vec![])?;
            self.tables[0].push(none);
            self.complete = order + 1;
            return Some(());
        }
        let particular = right_side.without_resonance_over_divisors()?.reduced();
        let displacement = self.normalised(particular)?;
        self.push_displacement(order, displacement)?;
        if self.variation.is_none() {
            self.complete = order + 1;
        }
        Some(())
    }

    /// `omega_n` from `W_n`.
    fn frequency(&self, order: usize, square: ShortFraction) -> Option<ShortFraction> {
        let mut frequency = square.half()?;
        // The sum over all pairs is twice that over one of each pair, plus the middle term.
        for i in (1..=order / 2).filter(|i| !self.frequency[*i].is_zero()) {
            let product = self.frequency[i].product(self.frequency[order - i])?;
            let product = if 2 * i == order { product.half()? } else { product };
            frequency = frequency.sum(product.negative())?;
        }
        Some(frequency)
    }

    /// `r_n` as in the head of the module.
    fn right_side(&mut self, order: usize) -> Option<ShortSeries> {
        if let Some(sine) = &mut self.sine {
            sine.prepare(order)?;
        }
        let at = |term: &PlannedTerm, table: usize| {
            self.tables[table].get(order.checked_sub(term.order)?)
        };
        let damped = derivative_of_parts(&self.parts(true, at)?)?;
        self.damped.push(damped);
        let at = |term: &PlannedTerm, table: usize| {
            self.tables[table].get(order.checked_sub(term.order)?)
        };
        let mut parts = self.parts(false, at)?;
        let of_sine = self.sine.as_ref().and_then(|sine| sine.rest.as_ref());
        parts.extend(of_sine.map(|rest| (1, 1, rest)));
        for (numerator, _, _) in &mut parts {
            *numerator = numerator.checked_neg()?;
        }
        let mut subtract = |factor: ShortFraction, series| {
            if !factor.is_zero() {
                parts.push((-factor.numerator(), factor.denominator(), series));
            }
        };
        for i in 1..=order {
            let present = self.plan.scheme.detuning == Detuning::Acceleration || i == order;
            if let Some(damped) = self.damped[i].as_ref().filter(|_| present) {
                subtract(self.frequency[order - i], damped);
            }
            if i < order {
                subtract(self.frequency_squared[order - i], &self.detuned[i]);
            }
        }
        parts.retain(|(_, _, series)| !series.is_zero());
        match parts.is_empty() {
            true => ShortSeries::new(self.plan.wave(order), self.harmonics(), 1, vec![0]),
            false => combination(&parts),
        }
    }

    /// The terms with a derivative or those without, each with the series that `at` selects from
    /// its table.
    fn parts<'b>(
        &'b self,
        derivative: bool,
        at: impl Fn(&PlannedTerm, usize) -> Option<&'b ShortSeries>,
    ) -> Option<Vec<(i128, i128, &'b ShortSeries)>> {
        // Room for the contributions of the frequency of all orders, too; mostly no term has a
        // derivative.
        let room = 2 * self.tables[0].len() + self.terms.len() + 1;
        let mut parts = if derivative { vec![] } else { Vec::with_capacity(room) };
        for ((term, coefficient), (table, own)) in self.terms.iter().zip(&self.plan.of_terms) {
            if let Some(series) = at(term, *table).filter(|_| *own == derivative) {
                let (numerator, denominator) = (*coefficient)?;
                parts.push((numerator, denominator, series));
            }
        }
        Some(parts)
    }

    /// Chooses the amplitude of `y_(order-1)` so that the right side of `order` has no secular
    /// sine.
    fn fix_amplitude(&mut self, order: usize, right_side: ShortSeries) -> Option<ShortSeries> {
        let (plan, variation) = (self.plan, self.variation.as_ref()?);
        let sine = right_side.coefficient(plan.resonant())?;
        if right_side.wave == Wave::Cosine || sine.is_zero() {
            return Some(right_side);
        }
        // The change of the amplitude is minus the sine over its slope.
        let amplitude = sine.quotient(variation.slope)?.negative();
        let change = (amplitude.numerator(), amplitude.denominator());
        let changed = |series: &ShortSeries, by: &ShortSeries| {
            combination(&[(1, 1, series), (change.0, change.1, by)]).map(ShortSeries::reduced)
        };
        for (table, by) in self.tables.iter_mut().zip(&variation.tables) {
            if let Some(series) = table.get_mut(order - 1) {
                *series = changed(series, by)?;
            }
        }
        let corrected = self.tables[0][order - 1].clone();
        if let (Some(damped), Some(by)) = (self.damped[order].as_mut(), &variation.damped) {
            *damped = changed(damped, by)?;
        }
        let right_side = changed(&right_side, &variation.right_side)?;
        self.detuned[order - 1] = frequency_factor(plan, &corrected)?;
        if plan.has_velocity {
            self.derived[order - 1] = corrected.derivative()?;
        }
        Some(right_side)
    }

    /// Adds to the solution of an order the homogeneous one that the amplitude convention asks for.
    fn normalised(&self, particular: ShortSeries) -> Option<ShortSeries> {
        let plan = self.plan;
        if plan.scheme.normalisation == AmplitudeConvention::FirstHarmonic {
            return Some(particular);
        }
        let mut numerators = particular.numerators().iter();
        let at_zero = match (particular.wave, plan.scheme.amplitude) {
            (Wave::Sine, _) => numerators.enumerate().try_fold(0_i128, |sum, (index, own)| {
                sum.checked_add(own.checked_mul(plan.harmonic(index) as i128)?)
            }),
            (Wave::Cosine, AmplitudeKind::Free) => {
                numerators.try_fold(0_i128, |sum, own| sum.checked_add(*own))
            }
            (Wave::Cosine, AmplitudeKind::Determined) => return Some(particular),
        };
        particular.with_numerator(plan.resonant(), at_zero?.checked_neg()?)
    }

    fn push_displacement(&mut self, order: usize, displacement: ShortSeries) -> Option<()> {
        let plan = self.plan;
        self.detuned.push(frequency_factor(plan, &displacement)?);
        if plan.has_velocity {
            self.derived.push(displacement.derivative()?);
            let velocity = match plan.scheme.detuning {
                Detuning::Displacement => self.derived[order].clone(),
                Detuning::Acceleration => {
                    let factors = self.frequency.iter().zip(self.derived.iter().rev());
                    let factors = factors.filter(|(factor, _)| !factor.is_zero());
                    let parts = factors
                        .map(|(factor, own)| (factor.numerator(), factor.denominator(), own));
                    combination(&parts.collect::<Vec<_>>())?.reduced()
                }
            };
            self.tables[1].push(velocity);
        }
        self.tables[0].push(displacement);
        for product in &plan.products {
            if order <= product.needed {
                let series = self.convolution(product, order)?;
                self.tables[product.to].push(series);
            }
        }
        match &mut self.sine {
            Some(sine) => sine.push(order, &self.tables[0][order]),
            None => Some(()),
        }
    }

    /// One order of a product.
    fn convolution(&self, product: &Product, order: usize) -> Option<ShortSeries> {
        let (left, right) = (&self.tables[product.left], &self.tables[product.right]);
        let sum = match product.left == product.right {
            true => square(&left[..=order]),
            false => convolution(&left[..=order], &right[..=order]),
        };
        sum.map(ShortSeries::reduced)
    }

    /// The first variation at order zero; `None` if the secular sine does not depend on the
    /// amplitude.
    fn variation(&self) -> Option<Variation> {
        let plan = self.plan;
        // The first tables, of y and of omega y', are their own variations.
        let leaves = 1 + usize::from(plan.has_velocity);
        let mut tables: Vec<ShortSeries> =
            self.tables[..leaves].iter().map(|table| table[0].clone()).collect();
        for product in &plan.products {
            let varied = |varied: usize, other: usize| {
                let own = std::slice::from_ref(&tables[varied]);
                convolution(own, &self.tables[other][..1])
            };
            let (left, right) =
                (varied(product.left, product.right)?, varied(product.right, product.left)?);
            let series = combination(&[(1, 1, &left), (1, 1, &right)])?.reduced();
            tables.push(series);
        }
        let at = |term: &PlannedTerm, table: usize| tables.get(table).filter(|_| term.order == 1);
        let plain = sum_of_parts(&self.parts(false, at)?)?;
        let damped = derivative_of_parts(&self.parts(true, at)?)?;
        let parts: Vec<_> = plain.iter().chain(&damped).map(|part| (-1, 1, part)).collect();
        let right_side = combination(&parts)?.reduced();
        let slope = right_side.coefficient(plan.resonant())?;
        (!slope.is_zero()).then_some(Variation { tables, right_side, damped, slope })
    }
}

/// `y_n''` or `-y_n`: what the corrections of the frequency multiply.
fn frequency_factor(plan: &Plan, displacement: &ShortSeries) -> Option<ShortSeries> {
    match plan.scheme.detuning {
        Detuning::Acceleration => displacement.second_derivative(),
        Detuning::Displacement => combination(&[(-1, 1, displacement)]),
    }
}

/// The sum of the parts; the inner `None` if there are none.
fn sum_of_parts(parts: &[(i128, i128, &ShortSeries)]) -> Option<Option<ShortSeries>> {
    match parts.is_empty() {
        true => Some(None),
        false => combination(parts).map(Some),
    }
}

/// The derivative of the sum of the parts; the inner `None` if there are none.
fn derivative_of_parts(parts: &[(i128, i128, &ShortSeries)]) -> Option<Option<ShortSeries>> {
    match sum_of_parts(parts)? {
        Some(sum) => Some(Some(sum.derivative()?.reduced())),
        None => Some(None),
    }
}

/// The [sine](super::sine) of the motion, order by order.
struct Sine {
    rate: (i128, i128),
    /// `V`, `S` and `C`.
    scaled: Vec<ShortSeries>,
    sine: Vec<ShortSeries>,
    cosine: Vec<ShortSeries>,
    /// `S` of the next order without the contribution of its own motion.
    rest: Option<ShortSeries>,
}

impl Sine {
    fn new(rate: (i128, i128)) -> Self {
        Self { rate, scaled: vec![], sine: vec![], cosine: vec![], rest: None }
    }

    /// Forms `S_n - y_n`, for the order after those that are known.
    fn prepare(&mut self, order: usize) -> Option<()> {
        let sum = convolution(&self.cosine[1..=order], &self.scaled[..order])?;
        let twice_and_half = 2 * i128::try_from(order).ok()? + 1;
        self.rest = Some(combination(&[(2, twice_and_half, &sum)])?.reduced());
        Some(())
    }

    /// Takes the motion of an order.
    fn push(&mut self, order: usize, displacement: &ShortSeries) -> Option<()> {
        let number = i128::try_from(order).ok()?;
        self.scaled.push(combination(&[(2 * number + 1, 2, displacement)])?.reduced());
        match self.rest.take() {
            Some(rest) => {
                self.sine.push(combination(&[(1, 1, &rest), (1, 1, displacement)])?.reduced())
            }
            None => {
                // At order zero the sine is the motion, and the cosine is one.
                self.sine.push(displacement.clone());
                let harmonics = displacement.harmonics().times(displacement.harmonics());
                self.cosine.push(ShortSeries::constant(harmonics, 1, 1)?);
            }
        }
        let sum = convolution(&self.sine[..=order], &self.scaled[..=order])?;
        let over = self.rate.1.checked_mul(number + 1)?;
        self.cosine.push(combination(&[(self.rate.0, over, &sum)])?.reduced());
        Some(())
    }
}

//! The first orders of an expansion in integers of fixed width, as far as they do not overflow.
//!
//! The recursion of the head of [the module](super) on [short series](crate::series::fixed_width),
//! whose symmetries are those of the [plan](super::modular) for primes. Low orders need no more
//! than this, and long expansions estimate the growth of their denominators from it.
//!
//! Cost: for every product `O(N^2 K^2)` multiplications of words to order `N` with `K` harmonics,
//! and two pieces of memory for each table, whatever the order; two words hold Duffing's equation to
//! order 25.

use super::plan::{Plan, PlannedTerm};
use super::{AmplitudeKind, Detuning, ExpansionScope};
use crate::interrupt::Interrupt;
use crate::series::fixed_width::{
    HarmonicParity, SeriesBuffer, ShortFraction, ShortSeries, ShortSeriesList,
};
use crate::series::waves::Wave;
use crate::solution::AmplitudeConvention;
use num_traits::ToPrimitive;

/// The first orders of an expansion in integers of fixed width.
#[derive(Default)]
pub(super) struct FirstOrders {
    /// Number of orders, from zero on; fewer than asked for if a number does not fit. The lists may
    /// be longer.
    pub count: usize,
    pub displacement: ShortSeriesList,
    /// `W_n` and `omega_n`.
    pub frequency_squared: Vec<ShortFraction>,
    pub frequency: Vec<ShortFraction>,
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
    let Some(mut recursion) = Recursion::new(plan, extent, |_| 1) else {
        return FirstOrders::default();
    };
    while recursion.complete <= last && !interrupt.is_requested() {
        if recursion.next_order().is_none()
            || (recursion.complete == few + 1 && !recursion.may_fit(last))
        {
            break;
        }
    }
    recursion.orders()
}

/// The expansion to the highest order of a plan, with the coefficient of each term multiplied by a
/// factor; `None` if a number does not fit.
pub(super) fn with_factors(
    plan: &Plan,
    extent: ExpansionScope,
    factor: impl Fn(usize) -> i128,
) -> Option<FirstOrders> {
    let mut recursion = Recursion::new(plan, extent, factor)?;
    while recursion.complete <= plan.highest {
        recursion.next_order()?;
    }
    Some(recursion.orders())
}

struct Recursion<'a> {
    plan: &'a Plan<'a>,
    extent: ExpansionScope,
    terms: Vec<Term<'a>>,
    /// The tables of the plan, an entry for each order; the first is the motion.
    tables: Vec<ShortSeriesList>,
    detuned: ShortSeriesList,
    derived: ShortSeriesList,
    /// The derivative of all terms with one velocity at each order; empty if there are none.
    damped: ShortSeriesList,
    /// Memory of the operations, and of the right side of an order.
    buffer: SeriesBuffer,
    right_side: SeriesBuffer,
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
    /// The only order of each table.
    tables: ShortSeriesList,
    /// The right side, and the derivative of the terms with one velocity.
    right_side: SeriesBuffer,
    damped: SeriesBuffer,
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
            // So that it has a negative.
            numerator.checked_neg()?;
            Some((numerator, denominator))
        };
        let terms = plan.terms.iter().zip(&plan.of_terms).enumerate();
        let last = plan.last.min(LONG + 1);
        let list = || ShortSeriesList::with_capacity(last + 1, plan.starts[last + 1]);
        let list_of = |is_needed: bool| if is_needed { list() } else { ShortSeriesList::default() };
        // The sums of harmonics of a product reach twice as far.
        let buffer = || SeriesBuffer::with_capacity(2 * plan.most_harmonics());
        let numbers = || {
            let mut numbers = Vec::with_capacity(last + 1);
            numbers.push(ShortFraction::ONE);
            numbers
        };
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
            derived: list_of(plan.has_velocity),
            damped: list_of(plan.of_terms.iter().any(|(_, derivative)| *derivative)),
            buffer: buffer(),
            right_side: buffer(),
            frequency_squared: numbers(),
            frequency: numbers(),
            variation: None,
            complete: 0,
        };
        let start: &[i128] = if plan.half_wave { &[1] } else { &[0, 1] };
        recursion.right_side.set(ShortSeries::new(Wave::Cosine, recursion.harmonics(), 1, start)?);
        recursion.push_displacement(0)?;
        match plan.scheme.amplitude {
            AmplitudeKind::Free => recursion.complete = 1,
            AmplitudeKind::Determined => recursion.variation = Some(recursion.variation()?),
        }
        Some(recursion)
    }

    /// Whether the denominators of an order will fit if they go on growing as they did.
    fn may_fit(&self, order: usize) -> bool {
        /// Number of binary digits that fit.
        const DIGITS: usize = 126;
        let digits = |order: usize| {
            let denominator = self.tables[0].get(order).map_or(1, ShortSeries::denominator);
            denominator.ilog2() as usize
        };
        let (last, middle) = (self.complete - 1, (self.complete - 1) / 2);
        let (grown, orders) = (digits(last).saturating_sub(digits(middle)), last - middle);
        digits(last) + grown * order.saturating_sub(last) / orders.max(1) <= DIGITS
    }

    fn harmonics(&self) -> HarmonicParity {
        match self.plan.half_wave {
            true => HarmonicParity::Odd,
            false => HarmonicParity::All,
        }
    }

    /// Returns the orders that are complete.
    fn orders(mut self) -> FirstOrders {
        FirstOrders {
            count: self.complete,
            displacement: self.tables.swap_remove(0),
            frequency_squared: self.frequency_squared,
            frequency: self.frequency,
            slope: self.variation.map(|variation| variation.slope),
        }
    }

    /// Solves the order after those that are known; the last one of a limit cycle only fixes the
    /// amplitude of the order before. `None` if a number overflows, or if a secular sine remains.
    fn next_order(&mut self) -> Option<()> {
        let (plan, order) = (self.plan, self.tables[0].len());
        self.form_right_side(order)?;
        if self.variation.is_some() {
            if order > 1 {
                self.fix_amplitude(order)?;
            }
            self.complete = order;
            if order > plan.highest {
                self.complete = plan.highest + 1;
                return Some(());
            }
        }
        let right_side = self.right_side.series();
        let resonance = right_side.coefficient(plan.resonant())?;
        let square = match right_side.wave() {
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
            let harmonics = self.harmonics();
            self.tables[0].push(ShortSeries::zero(plan.wave(order), harmonics));
            self.complete = order + 1;
            return Some(());
        }
        self.right_side.divide_by_divisors_without_resonance()?;
        self.right_side.reduce();
        self.normalise()?;
        self.push_displacement(order)?;
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

    /// Forms `r_n` as in the head of the module.
    fn form_right_side(&mut self, order: usize) -> Option<()> {
        if let Some(sine) = &mut self.sine {
            sine.prepare(order, &mut self.buffer)?;
        }
        let zero = ShortSeries::zero(self.plan.wave(order), self.harmonics());
        let Self { plan, terms, tables, frequency, frequency_squared, .. } = self;
        let at =
            |term: &PlannedTerm, table: usize| tables[table].get(order.checked_sub(term.order)?);
        if plan.of_terms.iter().any(|(_, derivative)| *derivative) {
            if order == 1 {
                self.damped.push(zero);
            }
            let damped = parts(plan, terms, true, at)?;
            match derivative_of_parts(damped, &mut self.buffer)? {
                true => self.damped.push(self.buffer.series()),
                false => self.damped.push(zero),
            }
        }
        // Room for the contributions of the frequency of all orders, too.
        let mut all = Vec::with_capacity(2 * order + terms.len() + 1);
        let mut subtract =
            |numerator: i128, denominator, series| all.push((-numerator, denominator, series));
        for (numerator, denominator, series) in parts(plan, terms, false, at)? {
            subtract(numerator, denominator, series);
        }
        if let Some(rest) = self.sine.as_ref().and_then(Sine::rest) {
            subtract(1, 1, rest);
        }
        for i in 1..=order {
            let present = plan.scheme.detuning == Detuning::Acceleration || i == order;
            if let Some(damped) = self.damped.get(i).filter(|_| present) {
                let factor = frequency[order - i];
                subtract(factor.numerator(), factor.denominator(), damped);
            }
            if let Some(detuned) = self.detuned.get(i).filter(|_| i < order) {
                let factor = frequency_squared[order - i];
                subtract(factor.numerator(), factor.denominator(), detuned);
            }
        }
        all.retain(|(numerator, _, series)| *numerator != 0 && !series.is_zero());
        match all.is_empty() {
            true => self.right_side.set(zero),
            false => self.right_side.set_combination(&all)?,
        }
        Some(())
    }

    /// Chooses the amplitude of `y_(order-1)` so that the right side of `order` has no secular
    /// sine.
    fn fix_amplitude(&mut self, order: usize) -> Option<()> {
        let (plan, variation) = (self.plan, self.variation.as_ref()?);
        let right_side = self.right_side.series();
        let sine = right_side.coefficient(plan.resonant())?;
        if right_side.wave() == Wave::Cosine || sine.is_zero() {
            return Some(());
        }
        // The change of the amplitude is minus the sine over its slope.
        let amplitude = sine.quotient(variation.slope)?.negative();
        let change = (amplitude.numerator(), amplitude.denominator());
        let buffer = &mut self.buffer;
        // The right side first: its memory is that of the buffer afterwards.
        set_changed(buffer, right_side, change, variation.right_side.series())?;
        std::mem::swap(buffer, &mut self.right_side);
        for (index, table) in self.tables.iter_mut().enumerate() {
            // A table ends before the orders that nothing needs.
            if let Some(series) = table.get(order - 1) {
                set_changed(buffer, series, change, variation.tables.get(index)?)?;
                table.replace_last(buffer.series());
            }
        }
        if let Some(damped) = self.damped.get(order) {
            set_changed(buffer, damped, change, variation.damped.series())?;
            self.damped.replace_last(buffer.series());
        }
        let corrected = self.tables[0].get(order - 1)?;
        set_frequency_factor(plan, corrected, buffer)?;
        self.detuned.replace_last(buffer.series());
        if plan.has_velocity {
            buffer.set_derivative(corrected)?;
            self.derived.replace_last(buffer.series());
        }
        Some(())
    }

    /// Adds to the solution of an order, which stands in place of the right side, the homogeneous
    /// one that the amplitude convention asks for.
    fn normalise(&mut self) -> Option<()> {
        let plan = self.plan;
        if plan.scheme.normalisation == AmplitudeConvention::FirstHarmonic {
            return Some(());
        }
        let particular = self.right_side.series();
        let mut numerators = particular.numerators().iter();
        let at_zero = match (particular.wave(), plan.scheme.amplitude) {
            (Wave::Sine, _) => numerators.enumerate().try_fold(0_i128, |sum, (index, own)| {
                sum.checked_add(own.checked_mul(plan.harmonic(index) as i128)?)
            }),
            (Wave::Cosine, AmplitudeKind::Free) => {
                numerators.try_fold(0_i128, |sum, own| sum.checked_add(*own))
            }
            (Wave::Cosine, AmplitudeKind::Determined) => return Some(()),
        };
        self.right_side.set_numerator(plan.resonant(), at_zero?.checked_neg()?)
    }

    /// Takes the motion of an order, which stands in place of the right side.
    fn push_displacement(&mut self, order: usize) -> Option<()> {
        let plan = self.plan;
        let (buffer, displacement) = (&mut self.buffer, self.right_side.series());
        set_frequency_factor(plan, displacement, buffer)?;
        self.detuned.push(buffer.series());
        self.tables[0].push(displacement);
        if plan.has_velocity {
            buffer.set_derivative(displacement)?;
            self.derived.push(buffer.series());
            if plan.scheme.detuning == Detuning::Acceleration {
                let factors = self.frequency.iter().enumerate().take(order + 1);
                let parts =
                    factors.filter(|(_, factor)| !factor.is_zero()).filter_map(|(i, own)| {
                        Some((own.numerator(), own.denominator(), self.derived.get(order - i)?))
                    });
                buffer.set_combination(&parts.collect::<Vec<_>>())?;
                buffer.reduce();
            }
            self.tables[1].push(buffer.series());
        }
        for product in &plan.products {
            if order <= product.needed {
                match product.left == product.right {
                    true => buffer.set_square(&self.tables[product.left], order)?,
                    false => {
                        let (left, right) =
                            (&self.tables[product.left], &self.tables[product.right]);
                        buffer.set_convolution(left, right, 0, order)?;
                    }
                }
                buffer.reduce();
                self.tables[product.to].push(buffer.series());
            }
        }
        match &mut self.sine {
            Some(sine) => sine.push(order, displacement, buffer),
            None => Some(()),
        }
    }

    /// The first variation at order zero; `None` if the secular sine does not depend on the
    /// amplitude.
    fn variation(&self) -> Option<Variation> {
        let plan = self.plan;
        // The first tables, of y and of omega y', are their own variations.
        let leaves = 1 + usize::from(plan.has_velocity);
        let mut tables = ShortSeriesList::default();
        for table in &self.tables[..leaves] {
            tables.push(table.get(0)?);
        }
        let [mut left, mut right, mut sum]: [SeriesBuffer; 3] = Default::default();
        for product in &plan.products {
            let varied = |varied: usize, other: usize, buffer: &mut SeriesBuffer| {
                buffer.set_product(tables.get(varied)?, self.tables[other].get(0)?)
            };
            varied(product.left, product.right, &mut left)?;
            varied(product.right, product.left, &mut right)?;
            let both = [(1, 1, left.series()), (1, 1, right.series())];
            sum.set_combination(&both)?;
            sum.reduce();
            tables.push(sum.series());
        }
        let [mut plain, mut damped, mut right_side]: [SeriesBuffer; 3] = Default::default();
        let (is_plain, is_damped) = {
            let at =
                |term: &PlannedTerm, table: usize| tables.get(table).filter(|_| term.order == 1);
            let parts_with = |derivative| parts(plan, &self.terms, derivative, at);
            let own = parts_with(false)?;
            let is_plain = own.clone().next().is_some();
            if is_plain {
                plain.set_combination(&own.collect::<Vec<_>>())?;
            }
            (is_plain, derivative_of_parts(parts_with(true)?, &mut damped)?)
        };
        let parts = [(is_plain, plain.series()), (is_damped, damped.series())].into_iter();
        let parts = parts.filter(|(is_any, _)| *is_any).map(|(_, series)| (-1, 1, series));
        right_side.set_combination(&parts.collect::<Vec<_>>())?;
        right_side.reduce();
        let slope = right_side.series().coefficient(plan.resonant())?;
        if slope.is_zero() {
            return None;
        }
        Some(Variation { tables, right_side, damped, slope })
    }
}

/// Sets `series + change by`, in lowest terms.
fn set_changed(
    buffer: &mut SeriesBuffer,
    series: ShortSeries,
    (numerator, denominator): (i128, i128),
    by: ShortSeries,
) -> Option<()> {
    buffer.set_combination(&[(1, 1, series), (numerator, denominator, by)])?;
    buffer.reduce();
    Some(())
}

/// A term of the force with its coefficient, divided by the power of which the term is a derivative;
/// `None` for one that overflows.
type Term<'a> = (&'a PlannedTerm, Option<(i128, i128)>);

/// The terms with a derivative or those without, each with the series that `at` selects from its
/// table; `None` if a coefficient of one is too long.
fn parts<'b>(
    plan: &'b Plan,
    terms: &'b [Term],
    derivative: bool,
    at: impl Fn(&PlannedTerm, usize) -> Option<ShortSeries<'b>> + Copy,
) -> Option<impl Iterator<Item = (i128, i128, ShortSeries<'b>)> + Clone> {
    let own = terms.iter().zip(&plan.of_terms).filter(move |(_, (_, own))| *own == derivative);
    let parts = own.filter_map(move |((term, coefficient), (table, _))| {
        at(term, *table).map(|series| (*coefficient, series))
    });
    let fits = parts.clone().all(|(coefficient, _)| coefficient.is_some());
    fits.then(|| {
        parts.filter_map(|(coefficient, series)| {
            coefficient.map(|(numerator, denominator)| (numerator, denominator, series))
        })
    })
}

/// Sets `y_n''` or `-y_n`: what the corrections of the frequency multiply.
fn set_frequency_factor(
    plan: &Plan,
    displacement: ShortSeries,
    buffer: &mut SeriesBuffer,
) -> Option<()> {
    match plan.scheme.detuning {
        Detuning::Acceleration => buffer.set_second_derivative(displacement),
        Detuning::Displacement => buffer.set_combination(&[(-1, 1, displacement)]),
    }
}

/// Sets the derivative of the sum of the parts; returns whether there are any.
fn derivative_of_parts<'a>(
    parts: impl Iterator<Item = (i128, i128, ShortSeries<'a>)> + Clone,
    buffer: &mut SeriesBuffer,
) -> Option<bool> {
    if parts.clone().next().is_none() {
        return Some(false);
    }
    buffer.set_combination(&parts.collect::<Vec<_>>())?;
    buffer.differentiate()?;
    buffer.reduce();
    Some(true)
}

/// The [sine](super::sine) of the motion, order by order.
struct Sine {
    rate: (i128, i128),
    /// `V`, `S` and `C`.
    scaled: ShortSeriesList,
    sine: ShortSeriesList,
    cosine: ShortSeriesList,
    /// `S` of the next order without the contribution of its own motion, from order one on.
    rest: ShortSeriesList,
}

impl Sine {
    fn new(rate: (i128, i128)) -> Self {
        let list = ShortSeriesList::default;
        Self { rate, scaled: list(), sine: list(), cosine: list(), rest: list() }
    }

    /// `S_n - y_n` of the order that has been prepared.
    fn rest(&self) -> Option<ShortSeries<'_>> {
        self.rest.get(0)
    }

    /// Forms `S_n - y_n`, for the order after those that are known.
    fn prepare(&mut self, order: usize, buffer: &mut SeriesBuffer) -> Option<()> {
        buffer.set_convolution(&self.cosine, &self.scaled, 1, order)?;
        let twice_and_half = 2 * i128::try_from(order).ok()? + 1;
        buffer.multiply(2, twice_and_half)?;
        self.rest.replace_last(buffer.series());
        Some(())
    }

    /// Takes the motion of an order.
    fn push(
        &mut self,
        order: usize,
        displacement: ShortSeries,
        buffer: &mut SeriesBuffer,
    ) -> Option<()> {
        let number = i128::try_from(order).ok()?;
        buffer.set(displacement);
        buffer.multiply(2 * number + 1, 2)?;
        self.scaled.push(buffer.series());
        match self.rest.get(0) {
            Some(rest) => {
                let both = [(1, 1, rest), (1, 1, displacement)];
                buffer.set_combination(&both)?;
                buffer.reduce();
                self.sine.push(buffer.series());
            }
            None => {
                // At order zero the sine is the motion, and the cosine is one.
                self.sine.push(displacement);
                let harmonics = displacement.harmonics().times(displacement.harmonics());
                self.cosine.push(ShortSeries::new(Wave::Cosine, harmonics, 1, &[1])?);
            }
        }
        buffer.set_convolution(&self.sine, &self.scaled, 0, order)?;
        buffer.multiply(self.rate.0, self.rate.1.checked_mul(number + 1)?)?;
        self.cosine.push(buffer.series());
        Some(())
    }
}

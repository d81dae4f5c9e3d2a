//! The first orders of an expansion in integers of fixed width, as far as they do not overflow.
//!
//! The recursion of the head of [the module](super) on [short series](crate::series::fixed_width),
//! whose symmetries are those of the [plan](super::modular) for primes. Low orders need no more
//! than this, and long expansions estimate the growth of their denominators from it.
//!
//! Cost: for every product `O(N^2 K^2)` multiplications of words to order `N` with `K` harmonics,
//! and two pieces of memory for each table, whatever the order. One word holds Duffing's equation to
//! order 11, two hold it to order 25.

use super::plan::{Plan, PlannedTerm};
use super::{AmplitudeKind, Detuning, ExpansionScope};
use crate::exact::Integer;
use crate::interrupt::Interrupt;
use crate::series::fixed_width::{
    FixedWidth, HarmonicParity, SeriesBuffer, ShortFraction, ShortSeries, ShortSeriesList,
};
use crate::series::waves::Wave;
use crate::solution::AmplitudeConvention;
use num_traits::{ToPrimitive as _, cast};

/// The first orders of an expansion in integers of fixed width.
pub(super) struct FirstOrders<W = i128> {
    /// Number of orders, from zero on; fewer than asked for if a number does not fit. The lists may
    /// be longer.
    pub count: usize,
    pub displacement: ShortSeriesList<W>,
    /// `W_n` and `omega_n`.
    pub frequency_squared: Vec<ShortFraction<W>>,
    pub frequency: Vec<ShortFraction<W>>,
    /// The derivative of the secular sine in the amplitude, where that is determined.
    pub slope: Option<ShortFraction<W>>,
}

impl<W> Default for FirstOrders<W> {
    fn default() -> Self {
        Self {
            count: 0,
            displacement: ShortSeriesList::default(),
            frequency_squared: vec![],
            frequency: vec![],
            slope: None,
        }
    }
}

/// Order beyond which two words are too short.
pub(super) const LONG: usize = 28;

/// Order beyond which one word is too short for expansions with symbols, and not tried.
pub(super) const SHORT: usize = 11;

/// The beginning of an expansion.
pub(super) enum Beginning {
    /// All orders of the plan, in one word.
    OneWord(FirstOrders<i64>),
    /// All orders of the plan in two words, or the first ones.
    TwoWords(FirstOrders),
}

/// The orders up to the highest of the plan, or as many as fit; of a long expansion, and of one that
/// will not fit, only as many as show how its denominators grow. The first ones are formed in one
/// word.
pub(super) fn beginning(plan: &Plan, extent: ExpansionScope, interrupt: Interrupt) -> Beginning {
    /// Number of orders that are computed of a long expansion.
    const ENOUGH: usize = 16;
    /// Number of orders that show whether the last one will fit, and how denominators grow.
    const FEW: usize = 10;
    let last = if plan.highest > LONG { ENOUGH } else { plan.highest };
    // Before its order a term leaves no trace in the denominators.
    let furthest = plan.terms.iter().map(|term| term.order).max().unwrap_or(0);
    let few = FEW.max(furthest);
    let mut narrow = Recursion::<i64>::new(plan, extent, |_| 1);
    if let Some(recursion) = &mut narrow {
        while recursion.complete <= last
            && !interrupt.is_requested()
            && recursion.next_order().is_some()
        {}
    }
    if let Some(recursion) = narrow.take_if(|recursion| recursion.complete > plan.highest) {
        return Beginning::OneWord(recursion.orders());
    }
    let Some(mut recursion) = Recursion::<i128>::new(plan, extent, |_| 1) else {
        return Beginning::TwoWords(FirstOrders::default());
    };
    if let Some(narrow) = narrow {
        recursion.go_on_from(&narrow);
    }
    let mut is_judged = false;
    while recursion.complete <= last && !interrupt.is_requested() {
        if !is_judged && recursion.complete > few {
            is_judged = true;
            if !recursion.may_fit(last) {
                break;
            }
        }
        if recursion.next_order().is_none() {
            break;
        }
    }
    Beginning::TwoWords(recursion.orders())
}

/// The expansion to the highest order of a plan, with the coefficient of each term multiplied by a
/// factor; `None` if a number does not fit.
pub(super) fn with_factors<W: FixedWidth>(
    plan: &Plan,
    extent: ExpansionScope,
    factor: impl Fn(usize) -> i64,
) -> Option<FirstOrders<W>> {
    let mut recursion = Recursion::new(plan, extent, factor)?;
    while recursion.complete <= plan.highest {
        recursion.next_order()?;
    }
    Some(recursion.orders())
}

struct Recursion<'a, W> {
    plan: &'a Plan<'a>,
    extent: ExpansionScope,
    terms: Vec<Term<'a, W>>,
    /// The tables of the plan, an entry for each order; the first is the motion.
    tables: Vec<ShortSeriesList<W>>,
    detuned: ShortSeriesList<W>,
    derived: ShortSeriesList<W>,
    /// The derivative of all terms with one velocity at each order; empty if there are none.
    damped: ShortSeriesList<W>,
    /// Memory of the operations, and of the right side of an order.
    buffer: SeriesBuffer<W>,
    right_side: SeriesBuffer<W>,
    frequency_squared: Vec<ShortFraction<W>>,
    frequency: Vec<ShortFraction<W>>,
    /// A sine in addition to the terms.
    sine: Option<Sine<W>>,
    variation: Option<Variation<W>>,
    /// Number of orders whose amplitudes are known, too.
    complete: usize,
}

impl Recursion<'_, i128> {
    /// Takes the orders that are complete in one word.
    fn go_on_from(&mut self, narrow: &Recursion<'_, i64>) {
        let count = narrow.complete;
        if count == 0 {
            return;
        }
        for (own, narrow) in self.tables.iter_mut().zip(&narrow.tables) {
            own.set_beginning(narrow, count);
        }
        self.detuned.set_beginning(&narrow.detuned, count);
        self.derived.set_beginning(&narrow.derived, count);
        // The first order begins this list.
        self.damped.set_beginning(&narrow.damped, if count > 1 { count } else { 0 });
        let widened = |all: &[ShortFraction<i64>]| {
            all.iter().take(count).map(|own| own.widened()).collect::<Vec<_>>()
        };
        self.frequency_squared = widened(&narrow.frequency_squared);
        self.frequency = widened(&narrow.frequency);
        if let (Some(own), Some(narrow)) = (&mut self.sine, &narrow.sine) {
            own.scaled.set_beginning(&narrow.scaled, count);
            own.sine.set_beginning(&narrow.sine, count);
            // The cosine is known to the next order.
            own.cosine.set_beginning(&narrow.cosine, count + 1);
        }
        self.complete = count;
    }
}

/// Derivatives of all quantities by the amplitude of `y_0`, for limit cycles.
struct Variation<W> {
    /// The only order of each table.
    tables: ShortSeriesList<W>,
    /// The right side, and the derivative of the terms with one velocity.
    right_side: SeriesBuffer<W>,
    damped: SeriesBuffer<W>,
    slope: ShortFraction<W>,
}

impl<'a, W: FixedWidth> Recursion<'a, W> {
    /// A recursion in which the coefficient of each term is multiplied by a factor.
    fn new(
        plan: &'a Plan<'a>,
        extent: ExpansionScope,
        factor: impl Fn(usize) -> i64,
    ) -> Option<Self> {
        let number = |own: &Integer| own.to_i128().and_then(cast::<i128, W>);
        let coefficient = |place: usize, term: &PlannedTerm, derivative: bool| {
            let power = if derivative { i64::from(term.position) + 1 } else { 1 };
            let denominator = number(term.coefficient.denom())?.product(cast(power)?)?;
            let numerator = number(term.coefficient.numer())?.product(cast(factor(place))?)?;
            // So that it has a negative.
            (numerator > W::min_value()).then_some((numerator, denominator))
        };
        let terms = plan.terms.iter().zip(&plan.of_terms).enumerate();
        let last = plan.last.min(LONG + 1);
        let list = || ShortSeriesList::with_capacity(last + 1, plan.starts[last + 1]);
        let list_of = |is_needed: bool| if is_needed { list() } else { ShortSeriesList::default() };
        // The sums of harmonics of a product reach twice as far.
        let buffer = || SeriesBuffer::with_capacity(2 * plan.most_harmonics());
        let numbers = || {
            let mut numbers = Vec::with_capacity(last + 1);
            numbers.push(ShortFraction::one());
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
                Some((_, rate)) => Some(Sine::new((number(rate.numer())?, number(rate.denom())?))),
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
        let start = [W::zero(), W::one()];
        let start = &start[usize::from(plan.half_wave)..];
        let motion = ShortSeries::new(Wave::Cosine, recursion.harmonics(), W::one(), start)?;
        recursion.right_side.set(motion);
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
            let denominator = self.tables[0].get(order).map_or(W::one(), ShortSeries::denominator);
            (W::zero().leading_zeros() - denominator.leading_zeros()).saturating_sub(1) as usize
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
    fn orders(mut self) -> FirstOrders<W> {
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
            Wave::Sine => ShortFraction::zero(),
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
    fn frequency(&self, order: usize, square: ShortFraction<W>) -> Option<ShortFraction<W>> {
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
        let Self { plan, terms, tables, damped, buffer, right_side, .. } = self;
        let (plan, frequency, frequency_squared) =
            (*plan, &*self.frequency, &*self.frequency_squared);
        let at =
            |term: &PlannedTerm, table: usize| tables[table].get(order.checked_sub(term.order)?);
        if plan.of_terms.iter().any(|(_, derivative)| *derivative) {
            if order == 1 {
                damped.push(zero);
            }
            match derivative_of_parts(parts(plan, terms, true, at)?, buffer)? {
                true => damped.push(buffer.series()),
                false => damped.push(zero),
            }
        }
        // Room for the contributions of the frequency of all orders, too.
        let mut all = Vec::with_capacity(2 * order + terms.len() + 1);
        let mut subtract = |numerator: W, denominator: W, series| {
            if !numerator.is_zero() && !ShortSeries::is_zero(series) {
                all.push((-numerator, denominator, series));
            }
        };
        for (numerator, denominator, series) in parts(plan, terms, false, at)? {
            subtract(numerator, denominator, series);
        }
        if let Some(rest) = self.sine.as_ref().and_then(Sine::rest) {
            subtract(W::one(), W::one(), rest);
        }
        for i in 1..=order {
            let present = plan.scheme.detuning == Detuning::Acceleration || i == order;
            if let Some(damped) = damped.get(i).filter(|_| present) {
                let factor = frequency[order - i];
                subtract(factor.numerator(), factor.denominator(), damped);
            }
            if let Some(detuned) = self.detuned.get(i).filter(|_| i < order) {
                let factor = frequency_squared[order - i];
                subtract(factor.numerator(), factor.denominator(), detuned);
            }
        }
        match all.is_empty() {
            true => right_side.set(zero),
            false => right_side.set_combination(&all)?,
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
            (Wave::Sine, _) => numerators.enumerate().try_fold(W::zero(), |sum, (index, own)| {
                sum.checked_add(&own.product(cast(plan.harmonic(index))?)?)
            }),
            (Wave::Cosine, AmplitudeKind::Free) => {
                numerators.try_fold(W::zero(), |sum, own| sum.checked_add(own))
            }
            (Wave::Cosine, AmplitudeKind::Determined) => return Some(()),
        };
        let at_zero = at_zero.filter(|sum| *sum > W::min_value())?;
        self.right_side.set_numerator(plan.resonant(), -at_zero)
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
    fn variation(&self) -> Option<Variation<W>> {
        let plan = self.plan;
        // The first tables, of y and of omega y', are their own variations.
        let leaves = 1 + usize::from(plan.has_velocity);
        let mut tables = ShortSeriesList::default();
        for table in &self.tables[..leaves] {
            tables.push(table.get(0)?);
        }
        let [mut left, mut right, mut sum]: [SeriesBuffer<W>; 3] = Default::default();
        for product in &plan.products {
            let varied = |varied: usize, other: usize, buffer: &mut SeriesBuffer<W>| {
                buffer.set_product(tables.get(varied)?, self.tables[other].get(0)?)
            };
            varied(product.left, product.right, &mut left)?;
            varied(product.right, product.left, &mut right)?;
            let both = [left.series(), right.series()];
            sum.set_combination(&both.map(|own| (W::one(), W::one(), own)))?;
            sum.reduce();
            tables.push(sum.series());
        }
        let [mut plain, mut damped, mut right_side]: [SeriesBuffer<W>; 3] = Default::default();
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
        let parts =
            parts.filter(|(is_any, _)| *is_any).map(|(_, series)| (-W::one(), W::one(), series));
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
fn set_changed<W: FixedWidth>(
    buffer: &mut SeriesBuffer<W>,
    series: ShortSeries<W>,
    (numerator, denominator): (W, W),
    by: ShortSeries<W>,
) -> Option<()> {
    buffer.set_combination(&[(W::one(), W::one(), series), (numerator, denominator, by)])?;
    buffer.reduce();
    Some(())
}

/// A term of the force with its coefficient, divided by the power of which the term is a derivative;
/// `None` for one that overflows.
type Term<'a, W> = (&'a PlannedTerm, Option<(W, W)>);

/// The terms with a derivative or those without, each with the series that `at` selects from its
/// table; `None` if a coefficient of one is too long.
fn parts<'b, W: FixedWidth>(
    plan: &'b Plan,
    terms: &'b [Term<W>],
    derivative: bool,
    at: impl Fn(&PlannedTerm, usize) -> Option<ShortSeries<'b, W>> + Copy,
) -> Option<impl Iterator<Item = (W, W, ShortSeries<'b, W>)> + Clone> {
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
fn set_frequency_factor<W: FixedWidth>(
    plan: &Plan,
    displacement: ShortSeries<W>,
    buffer: &mut SeriesBuffer<W>,
) -> Option<()> {
    match plan.scheme.detuning {
        Detuning::Acceleration => buffer.set_second_derivative(displacement),
        Detuning::Displacement => buffer.set_combination(&[(-W::one(), W::one(), displacement)]),
    }
}

/// Sets the derivative of the sum of the parts; returns whether there are any.
fn derivative_of_parts<'a, W: FixedWidth + 'a>(
    parts: impl Iterator<Item = (W, W, ShortSeries<'a, W>)> + Clone,
    buffer: &mut SeriesBuffer<W>,
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
struct Sine<W> {
    rate: (W, W),
    /// `V`, `S` and `C`.
    scaled: ShortSeriesList<W>,
    sine: ShortSeriesList<W>,
    cosine: ShortSeriesList<W>,
    /// `S` of the next order without the contribution of its own motion, from order one on.
    rest: ShortSeriesList<W>,
}

impl<W: FixedWidth> Sine<W> {
    fn new(rate: (W, W)) -> Self {
        let list = ShortSeriesList::default;
        Self { rate, scaled: list(), sine: list(), cosine: list(), rest: list() }
    }

    /// `S_n - y_n` of the order that has been prepared.
    fn rest(&self) -> Option<ShortSeries<'_, W>> {
        self.rest.get(0)
    }

    /// Forms `S_n - y_n`, for the order after those that are known.
    fn prepare(&mut self, order: usize, buffer: &mut SeriesBuffer<W>) -> Option<()> {
        buffer.set_convolution(&self.cosine, &self.scaled, 1, order)?;
        buffer.multiply(cast(2)?, cast(2 * order + 1)?)?;
        self.rest.replace_last(buffer.series());
        Some(())
    }

    /// Takes the motion of an order.
    fn push(
        &mut self,
        order: usize,
        displacement: ShortSeries<W>,
        buffer: &mut SeriesBuffer<W>,
    ) -> Option<()> {
        buffer.set(displacement);
        buffer.multiply(cast(2 * order + 1)?, cast(2)?)?;
        self.scaled.push(buffer.series());
        match self.rest.get(0) {
            Some(rest) => {
                let both = [rest, displacement];
                buffer.set_combination(&both.map(|own| (W::one(), W::one(), own)))?;
                buffer.reduce();
                self.sine.push(buffer.series());
            }
            None => {
                // At order zero the sine is the motion, and the cosine is one.
                self.sine.push(displacement);
                let harmonics = displacement.harmonics().times(displacement.harmonics());
                let one = [W::one()];
                self.cosine.push(ShortSeries::new(Wave::Cosine, harmonics, W::one(), &one)?);
            }
        }
        buffer.set_convolution(&self.sine, &self.scaled, 0, order)?;
        buffer.multiply(self.rate.0, self.rate.1.product(cast(order + 1)?)?)?;
        self.cosine.push(buffer.series());
        Some(())
    }
}

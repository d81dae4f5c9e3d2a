//! The elimination of secular terms modulo eight primes at once, on values at points.
//!
//! The [recursion in a ring](super) with three changes that make it fast. Products of series are
//! sums of products of values at [points](crate::series::waves), `sum_i u_i v_(n-i)`, instead of
//! products of Fourier series. A term `y^p (omega y')` is the derivative of `y^(p+1)/(p+1)` and
//! needs no values of the velocity. And everything is a [residue](crate::exact::residue), of eight
//! runs side by side: modulo eight primes, or modulo one with eight sets of coefficients.
//!
//! Cost for `P` products to order `N` with `K` harmonics: `P K N^2/2` multiplications of words
//! (half for a square), `K N^2/6` for each series that is multiplied by the frequency, and `N`
//! transforms each way.

use std::ops::Range;

use pulp::NullaryFnOnce;

use super::plan::{HarmonicTable, Plan};
use super::sine::SineFactors;
use super::{AmplitudeKind, Detuning};
use crate::exact::Rational;
use crate::exact::residue::sums::{
    MixtureTerm, TOGETHER, add_multiple, convolve, mixture, multiply, reversed_products, subtract,
    vary,
};
use crate::exact::residue::{Arithmetic, Lanes, Moduli, Modulus, Residues, Tables};
use crate::interrupt::Interrupt;
use crate::series::waves::{Wave, Waves};
use crate::solution::AmplitudeConvention;

/// The expansion modulo one prime: plain residues, order by order.
pub(super) struct PrimeImage {
    pub modulus: Modulus,
    /// The coefficients of the harmonics of `y_n` from the order on that is wanted from this prime.
    displacement: Vec<u64>,
    /// Index of the first of them among the coefficients of all orders.
    start: usize,
    /// `W_n`.
    pub frequency_squared: Vec<u64>,
    /// `omega_n`.
    pub frequency: Vec<u64>,
}

impl PrimeImage {
    /// The coefficients of an order; empty if they are not wanted from this prime.
    pub fn displacement(&self, plan: &Plan, order: usize) -> &[u64] {
        let places = plan.coefficient_range(order);
        let Some(start) = places.start.checked_sub(self.start) else {
            return &[];
        };
        self.displacement.get(start..places.end - self.start).unwrap_or(&[])
    }
}

/// Runs the recursion, eight runs at a time, in the same memory.
pub(super) struct Recursion<'a, A> {
    arithmetic: A,
    plan: &'a Plan<'a>,
    interrupt: Interrupt,
    /// Values at the points, an entry for each order; of a product that is not a factor of another,
    /// only the latest.
    tables: Tables<'a>,
    /// The coefficients of the harmonics of all orders.
    motion: HarmonicTable<'a>,
    /// The coefficients of the derivative of all terms with one velocity.
    damped: HarmonicTable<'a>,
    frequency_squared: Vec<Lanes>,
    frequency: Vec<Lanes>,
    of_amplitude: Option<Variation>,
    values: Vec<Lanes>,
    reversed: Vec<Lanes>,
    parts: Vec<MixtureTerm>,
    right_side: Vec<Lanes>,
    change: Vec<Lanes>,
}

/// Constants of the recursion modulo eight primes.
pub(super) struct ResidueField<A> {
    pub residues: Residues<A>,
    waves: Waves,
    factors: Factors,
    /// The coefficients of the terms, each divided by the power of which the term is a derivative.
    pub coefficients: Vec<Lanes>,
    sine: Option<SineFactors>,
}

impl<A: Arithmetic> ResidueField<A> {
    /// Prepares up to eight primes; `None` if a divisor is a multiple of one of them.
    pub fn new(arithmetic: A, plan: &Plan, moduli: &[Modulus]) -> Option<Self> {
        arithmetic.vectorize(Prepare(arithmetic, plan, moduli))
    }
}

struct Prepare<'a, A>(A, &'a Plan<'a>, &'a [Modulus]);

impl<A: Arithmetic> NullaryFnOnce for Prepare<'_, A> {
    type Output = Option<ResidueField<A>>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Self(arithmetic, plan, moduli) = self;
        let residues = Residues { arithmetic, moduli: Moduli::from_primes(moduli) };
        let mut coefficients = Vec::with_capacity(plan.terms.len());
        for (term, (_, derivative)) in plan.terms.iter().zip(&plan.of_terms) {
            let power = if *derivative { i64::from(term.position) + 1 } else { 1 };
            coefficients.push(coefficient(moduli, &term.coefficient, power)?);
        }
        Some(ResidueField {
            residues,
            waves: Waves::new(&residues, plan.grid)?,
            factors: Factors::new(&residues, plan)?,
            coefficients,
            sine: match &plan.sine {
                Some((_, rate)) => {
                    Some(SineFactors::new(&residues, coefficient(moduli, rate, 1)?, plan.last)?)
                }
                None => None,
            },
        })
    }
}

/// A number over a power, modulo each prime; `None` if a prime divides its denominator.
fn coefficient(moduli: &[Modulus], number: &Rational, power: i64) -> Option<Lanes> {
    let mut lanes = Lanes::default();
    let mut last = 0;
    for (lane, own) in lanes.0.iter_mut().enumerate() {
        if let Some(modulus) = moduli.get(lane) {
            let divisor = modulus.product(modulus.integer(number.denom()), modulus.small(power));
            if divisor == 0 {
                return None;
            }
            let numerator = modulus.integer(number.numer());
            last = match divisor == modulus.one {
                true => numerator,
                false => modulus.product(numerator, modulus.inverse(divisor)),
            };
        }
        *own = last;
    }
    Some(lanes)
}

/// Factors of the coefficients of the harmonics, one by one.
struct Factors {
    /// `1/(1 - k^2)`, zero for the first harmonic.
    solution: Vec<Lanes>,
    /// `-k^2`, or minus one if the frequency multiplies `y`.
    detuning: Vec<Lanes>,
    /// `k`, which takes sines to the cosines of their derivative.
    rising: Vec<Lanes>,
    /// `-k`, which takes cosines to the sines of their derivative.
    falling: Vec<Lanes>,
}

impl Factors {
    #[inline(always)]
    fn new<A: Arithmetic>(residues: &Residues<A>, plan: &Plan) -> Option<Self> {
        let (one, count) = (residues.one(), plan.most_harmonics());
        let mut rising = vec![one; count];
        let mut falling = vec![one; count];
        let mut solution = vec![one; count];
        let mut detuning = vec![residues.negative(one); count];
        for index in 0..count {
            let harmonic = residues.small(plan.harmonic(index));
            let square = residues.product(harmonic, harmonic);
            rising[index] = harmonic;
            falling[index] = residues.negative(harmonic);
            if index != plan.resonant() {
                solution[index] = residues.difference(one, square);
            }
            if plan.scheme.detuning == Detuning::Acceleration {
                detuning[index] = residues.negative(square);
            }
        }
        residues.invert(&mut solution)?;
        solution[plan.resonant()] = Lanes::default();
        Some(Self { solution, detuning, rising, falling })
    }

    /// The factors of the derivative of a sum of these waves.
    fn derivative(&self, of: Wave) -> &[Lanes] {
        match of {
            Wave::Cosine => &self.falling,
            Wave::Sine => &self.rising,
        }
    }
}

/// Derivatives of all quantities by the amplitude of `y_0`, for limit cycles.
struct Variation {
    /// The values of each table.
    tables: Vec<Vec<Lanes>>,
    /// The right side without the terms with one velocity, and those terms.
    plain: Vec<Lanes>,
    damped: Vec<Lanes>,
    /// `1/J`.
    inverse_slope: Lanes,
}

/// Converts the last expansion from Montgomery's form to plain residues.
struct ToPlainResidues<'r, 'a, A>(&'r mut Recursion<'a, A>, &'r Residues<A>);

impl<A: Arithmetic> NullaryFnOnce for ToPlainResidues<'_, '_, A> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(recursion, residues) = self;
        for own in recursion.motion.entries() {
            *own = residues.plain(*own);
        }
        for constants in [&mut recursion.frequency_squared, &mut recursion.frequency] {
            for own in constants {
                *own = residues.plain(*own);
            }
        }
    }
}

struct ExpandOrders<'r, 'a, A>(&'r mut Recursion<'a, A>, &'r mut ResidueField<A>, &'r [Lanes]);

impl<A: Arithmetic> NullaryFnOnce for ExpandOrders<'_, '_, A> {
    type Output = Option<()>;

    #[inline(always)]
    fn call(self) -> Option<()> {
        let Self(recursion, field, coefficients) = self;
        recursion.expand_here(field, coefficients)
    }
}

impl<'a, A: Arithmetic> Recursion<'a, A> {
    /// Number of entries that all orders take.
    pub fn entry_count(plan: &Plan) -> usize {
        let tables = Tables::entry_count(plan.grid.size(), &Self::lengths(plan));
        tables
            + Self::harmonics(plan)
                .map(|count| HarmonicTable::entry_count(plan, count))
                .iter()
                .sum::<usize>()
    }

    /// The entries in a row of each table.
    fn lengths(plan: &Plan) -> Vec<usize> {
        let orders = plan.last + 1;
        let furthest = plan.terms.iter().map(|term| term.order).max().unwrap_or(0);
        let latest = orders.min((TOGETHER + furthest).next_multiple_of(TOGETHER));
        let mut lengths = vec![orders; plan.tables];
        for product in plan.products.iter().chain(plan.sine_products()) {
            lengths[product.to] = latest;
        }
        for product in plan.products.iter().chain(plan.sine_products()) {
            (lengths[product.left], lengths[product.right]) = (orders, orders);
        }
        lengths
    }

    /// Numbers of harmonics of the motion, and of the terms with one velocity.
    fn harmonics(plan: &Plan) -> [usize; 2] {
        let has_damping = plan.of_terms.iter().any(|(_, derivative)| *derivative);
        [plan.most_harmonics(), if has_damping { plan.most_harmonics() } else { 0 }]
    }

    /// An empty recursion in slices of [these sizes](Self::entry_count).
    pub fn new(
        arithmetic: A,
        plan: &'a Plan<'a>,
        interrupt: Interrupt,
        memory: &'a mut [Lanes],
    ) -> Self {
        let orders = plan.last + 1;
        let points = plan.grid.size();
        let none = Lanes::default();
        let lengths = Self::lengths(plan);
        let (tables, rest) = memory.split_at_mut(Tables::entry_count(points, &lengths));
        let [harmonics, of_damped] = Self::harmonics(plan);
        let (motion, damped) = rest.split_at_mut(HarmonicTable::entry_count(plan, harmonics));
        Self {
            arithmetic,
            plan,
            interrupt,
            tables: Tables::new(points, &lengths, tables),
            motion: HarmonicTable::new(plan, harmonics, motion),
            damped: HarmonicTable::new(plan, of_damped, damped),
            frequency_squared: Vec::with_capacity(orders),
            frequency: Vec::with_capacity(orders),
            of_amplitude: None,
            values: vec![none; points],
            reversed: Vec::with_capacity(orders),
            parts: Vec::with_capacity(plan.terms.len()),
            right_side: vec![none; harmonics],
            change: vec![none; harmonics],
        }
    }

    /// The expansion modulo each of up to eight primes, with the motion from the order `wanted` of
    /// each prime on. `None` if a divisor is a multiple of a prime, if a secular sine remains (the
    /// recursion in the ring names its order), or if the work is interrupted.
    pub fn images(
        &mut self,
        primes: &[u64],
        wanted: &dyn Fn(usize) -> usize,
    ) -> Option<Vec<PrimeImage>> {
        let moduli: Vec<Modulus> =
            primes.iter().map(|prime| Modulus::new(*prime, A::RADIX)).collect();
        let mut field = ResidueField::new(self.arithmetic, self.plan, &moduli)?;
        let coefficients = std::mem::take(&mut field.coefficients);
        self.expand(&mut field, &coefficients)?;
        self.arithmetic.vectorize(ToPlainResidues(self, &field.residues));
        let plan = self.plan;
        let image = |(lane, modulus): (usize, &Modulus)| {
            let own = |residues: &[Lanes]| residues.iter().map(|own| own.0[lane]).collect();
            let first = wanted(lane).min(plan.highest + 1);
            let (start, end) = (plan.starts[first], plan.starts[plan.highest + 1]);
            let mut displacement = Vec::with_capacity(end - start);
            for order in first..=plan.highest {
                displacement.extend(self.displacement(order).map(|own| own.0[lane]));
            }
            PrimeImage {
                modulus: *modulus,
                displacement,
                start,
                frequency_squared: own(&self.frequency_squared),
                frequency: own(&self.frequency),
            }
        };
        Some(moduli.iter().enumerate().map(image).collect())
    }

    /// `W_n` of what was expanded last, in Montgomery's form as the others.
    pub fn frequency_squared(&self) -> &[Lanes] {
        &self.frequency_squared
    }

    /// `omega_n`.
    pub fn frequency(&self) -> &[Lanes] {
        &self.frequency
    }

    /// The coefficients of the harmonics of `y_n`.
    pub fn displacement(&self, order: usize) -> impl Iterator<Item = Lanes> {
        let harmonics = 0..self.plan.harmonics(order);
        harmonics.map(move |index| self.motion.coefficient(self.plan, index, order))
    }

    /// Expands with these coefficients of the terms.
    pub fn expand(&mut self, field: &mut ResidueField<A>, coefficients: &[Lanes]) -> Option<()> {
        self.arithmetic.vectorize(ExpandOrders(self, field, coefficients))
    }

    #[inline(always)]
    fn expand_here(&mut self, field: &mut ResidueField<A>, coefficients: &[Lanes]) -> Option<()> {
        let (plan, one) = (self.plan, field.residues.one());
        self.frequency_squared.clear();
        self.frequency.clear();
        self.frequency_squared.push(one);
        self.frequency.push(one);
        self.right_side.fill(Lanes::default());
        self.right_side[plan.resonant()] = one;
        self.of_amplitude = None;
        self.motion.clear();
        self.damped.clear();
        // No terms stand at order zero.
        self.change.fill(Lanes::default());
        self.damped.push(plan, 0, &self.change[..plan.harmonics(0)]);
        for order in 0..=plan.last {
            if order > 0 {
                self.form_right_side(field, coefficients, order);
                if order > 1 {
                    self.fix_amplitude(field, order);
                }
                if order > plan.highest {
                    break;
                }
                self.solve_order(field, order)?;
            }
            self.push_displacement(field, order);
            if order == 0 && plan.scheme.amplitude == AmplitudeKind::Determined {
                self.of_amplitude = Some(self.variation(field, coefficients)?);
                if plan.highest == 0 {
                    break;
                }
            }
            if self.interrupt.is_requested() {
                return None;
            }
        }
        Some(())
    }

    /// Replaces the right side of an order by its solution, and computes the frequency.
    #[inline(always)]
    fn solve_order(&mut self, field: &ResidueField<A>, order: usize) -> Option<()> {
        let (residues, resonant) = (&field.residues, self.plan.resonant());
        let square = match self.plan.wave(order) {
            Wave::Sine if self.right_side[resonant] != Lanes::default() => return None,
            Wave::Sine => Lanes::default(),
            Wave::Cosine => residues.negative(self.right_side[resonant]),
        };
        // The sum over all pairs is twice that over one of each pair, plus the middle term.
        let mut products = Lanes::default();
        for i in 1..order.div_ceil(2) {
            if self.frequency[i] != Lanes::default() {
                let product = residues.product(self.frequency[i], self.frequency[order - i]);
                products = residues.sum(products, product);
            }
        }
        products = residues.sum(products, products);
        if order.is_multiple_of(2) {
            let middle = self.frequency[order / 2];
            products = residues.sum(products, residues.product(middle, middle));
        }
        let twice = residues.difference(square, products);
        self.frequency_squared.push(square);
        self.frequency.push(residues.product(twice, field.waves.half()));
        let count = self.plan.harmonics(order);
        multiply(residues, &mut self.right_side[..count], &field.factors.solution);
        self.normalise(field, order);
        Some(())
    }

    /// `r_n` as in the head of the module, in the coefficients of its harmonics.
    #[inline(always)]
    fn form_right_side(
        &mut self,
        field: &mut ResidueField<A>,
        coefficients: &[Lanes],
        order: usize,
    ) {
        let residues = field.residues;
        let (plan, wave) = (self.plan, self.plan.wave(order));
        let count = plan.harmonics(order);
        let mut right_side = std::mem::take(&mut self.right_side);
        let mut change = std::mem::take(&mut self.change);
        let out = &mut right_side[..count];
        let change_here = &mut change[..count];
        out.fill(Lanes::default());
        self.prepare_sine(field, order);
        for derivative in [false, true] {
            let any = self.mix(field, coefficients, order, derivative);
            let own = if derivative { wave.other() } else { wave };
            match any {
                true => field.waves.coefficients(&residues, own, &mut self.values, change_here),
                false => change_here.fill(Lanes::default()),
            }
            if derivative {
                multiply(&residues, change_here, field.factors.derivative(own));
                self.damped.push(plan, order, change_here);
                if any && plan.scheme.detuning == Detuning::Acceleration {
                    self.delayed(
                        &residues,
                        FrequencyFactor::Damped,
                        order,
                        1..order + 1,
                        change_here,
                    );
                }
            }
            subtract(&residues, out, change_here);
        }
        if order > 1 {
            self.delayed(&residues, FrequencyFactor::Motion, order, 1..order, change_here);
            multiply(&residues, change_here, &field.factors.detuning);
            subtract(&residues, out, change_here);
        }
        (self.right_side, self.change) = (right_side, change);
    }

    /// The sum of all terms at an order, with a derivative or without, into `values`; whether there
    /// are any such terms.
    #[inline(always)]
    fn mix(
        &mut self,
        field: &ResidueField<A>,
        coefficients: &[Lanes],
        order: usize,
        derivative: bool,
    ) -> bool {
        self.parts.clear();
        for ((term, (table, own)), factor) in
            self.plan.terms.iter().zip(&self.plan.of_terms).zip(coefficients)
        {
            if *own == derivative && term.order <= order {
                self.parts.push(MixtureTerm {
                    factor: *factor,
                    table: *table,
                    order: order - term.order,
                });
            }
        }
        if let (Some((sine, _)), Some(factors), false) = (&self.plan.sine, &field.sine, derivative)
        {
            self.parts.push(factors.sine(sine, order));
        }
        if !self.parts.is_empty() {
            mixture(&field.residues, &self.parts, &self.tables, &mut self.values);
        }
        !self.parts.is_empty()
    }

    /// The sum of `S_n` without its last term, because `y_n` is not known yet.
    #[inline(always)]
    fn prepare_sine(&mut self, field: &ResidueField<A>, order: usize) {
        if let Some((sine, _)) = &self.plan.sine {
            self.values.fill(Lanes::default());
            self.tables.write(sine.scaled, order, &self.values);
            let products = std::slice::from_ref(&sine.of_sine);
            convolve(&field.residues, products, &mut self.tables, order);
        }
    }

    /// Sine and cosine at an order whose `y_n` stands in its table, the cosine of the next one too.
    #[inline(always)]
    fn push_sine(&mut self, field: &ResidueField<A>, order: usize) {
        let (Some((sine, _)), Some(factors)) = (&self.plan.sine, &field.sine) else {
            return;
        };
        let residues = &field.residues;
        let whole = MixtureTerm { factor: residues.one(), table: 0, order };
        self.form(residues, &[factors.scaled(order)], (sine.scaled, order));
        match order {
            0 => {
                self.form(residues, &[whole], (sine.sine, 0));
                self.values.fill(residues.one());
                self.tables.write(sine.cosine, 0, &self.values);
            }
            _ => self.form(residues, &[factors.sine(sine, order), whole], (sine.sine, order)),
        }
        let products = std::slice::from_ref(&sine.of_cosine);
        convolve(residues, products, &mut self.tables, order);
        if order < self.plan.last {
            self.form(residues, &[factors.cosine(sine, order)], (sine.cosine, order + 1));
        }
    }

    /// Writes a mixture of tables into one of them.
    #[inline(always)]
    fn form(
        &mut self,
        residues: &Residues<A>,
        parts: &[MixtureTerm],
        (table, order): (usize, usize),
    ) {
        mixture(residues, parts, &self.tables, &mut self.values);
        self.tables.write(table, order, &self.values);
    }

    /// `out = sum over i in range of frequency_(order-i) series_i`, where orders of the other
    /// symmetry are zero.
    #[inline(always)]
    fn delayed(
        &mut self,
        residues: &Residues<A>,
        series: FrequencyFactor,
        order: usize,
        range: Range<usize>,
        out: &mut [Lanes],
    ) {
        let plan = self.plan;
        let (harmonics, frequency) = match series {
            FrequencyFactor::Motion => (&self.motion, &self.frequency_squared),
            FrequencyFactor::Velocity => (&self.motion, &self.frequency),
            FrequencyFactor::Damped => (&self.damped, &self.frequency),
        };
        let step = plan.step();
        // The latest order comes first, because the frequencies are stored so.
        let last = range.end - 1 - (order + range.end - 1) % step;
        self.reversed.clear();
        for i in (range.start..=last).rev().step_by(step) {
            self.reversed.push(frequency[order - i]);
        }
        for (index, out) in out.iter_mut().enumerate() {
            let (first, row) = harmonics.row(plan, index, order);
            let Some(count) = last.checked_sub(first) else {
                *out = Lanes::default();
                continue;
            };
            let row = &row[..count / step + 1];
            let count = row.len().min(self.reversed.len());
            *out = residues.reduce(reversed_products(
                residues.arithmetic,
                &self.reversed[..count],
                &row[row.len() - count..],
            ));
        }
    }

    /// Chooses the amplitude of `y_(order-1)` so that the right side of `order` has no secular
    /// sine.
    #[inline(always)]
    fn fix_amplitude(&mut self, field: &ResidueField<A>, order: usize) {
        let Some(variation) = &self.of_amplitude else {
            return;
        };
        let (residues, plan, resonant) = (&field.residues, self.plan, self.plan.resonant());
        if plan.wave(order) == Wave::Cosine {
            return;
        }
        let secular = residues.negative(self.right_side[resonant]);
        let amplitude = residues.product(secular, variation.inverse_slope);
        for (table, change) in variation.tables.iter().enumerate() {
            vary(residues, &mut self.tables, (table, order - 1), amplitude, change);
        }
        add_multiple(residues, &mut self.right_side, amplitude, &variation.plain);
        let minus = residues.negative(amplitude);
        add_multiple(residues, &mut self.right_side, minus, &variation.damped);
        if let Some(first) = self.motion.last(order - 1, resonant) {
            *first = residues.sum(*first, amplitude);
        }
        for (index, change) in variation.damped.iter().enumerate() {
            if let Some(last) = self.damped.last(order, index) {
                *last = residues.sum(*last, residues.product(amplitude, *change));
            }
        }
    }

    /// Adds to the solution of an order the homogeneous one that the amplitude convention asks for.
    #[inline(always)]
    fn normalise(&mut self, field: &ResidueField<A>, order: usize) {
        if self.plan.scheme.normalisation == AmplitudeConvention::FirstHarmonic {
            return;
        }
        let residues = &field.residues;
        let displacement = &mut self.right_side[..self.plan.harmonics(order)];
        let mut at_zero = Lanes::default();
        match (self.plan.wave(order), self.plan.scheme.amplitude) {
            (Wave::Sine, _) => {
                for (value, k) in displacement.iter().zip(&field.factors.rising) {
                    at_zero = residues.sum(at_zero, residues.product(*value, *k));
                }
            }
            (Wave::Cosine, AmplitudeKind::Free) => {
                for value in displacement.iter() {
                    at_zero = residues.sum(at_zero, *value);
                }
            }
            (Wave::Cosine, AmplitudeKind::Determined) => return,
        }
        displacement[self.plan.resonant()] = residues.negative(at_zero);
    }

    /// Stores the solution in `right_side` as `y_n`.
    #[inline(always)]
    fn push_displacement(&mut self, field: &mut ResidueField<A>, order: usize) {
        let residues = field.residues;
        let plan = self.plan;
        let (wave, count) = (plan.wave(order), plan.harmonics(order));
        let displacement = &self.right_side[..count];
        self.motion.push(plan, order, displacement);
        field.waves.values(&residues, wave, displacement, &mut self.values);
        self.tables.write(0, order, &self.values);
        if plan.has_velocity {
            let mut change = std::mem::take(&mut self.change);
            let own = &mut change[..count];
            match plan.scheme.detuning {
                Detuning::Acceleration => {
                    self.delayed(&residues, FrequencyFactor::Velocity, order, 0..order + 1, own)
                }
                Detuning::Displacement => own.copy_from_slice(displacement),
            }
            multiply(&residues, own, field.factors.derivative(wave));
            field.waves.values(&residues, wave.other(), own, &mut self.values);
            self.tables.write(1, order, &self.values);
            self.change = change;
        }
        convolve(&residues, &plan.products, &mut self.tables, order);
        self.push_sine(field, order);
    }

    /// The first variation at order zero; `None` if the secular sine does not depend on the
    /// amplitude.
    #[inline(always)]
    fn variation(
        &mut self,
        field: &mut ResidueField<A>,
        coefficients: &[Lanes],
    ) -> Option<Variation> {
        let (residues, plan) = (field.residues, self.plan);
        let points = self.values.len();
        let none = Lanes::default();
        let mut tables: Vec<Vec<Lanes>> = Vec::with_capacity(plan.tables);
        // The first tables, of y and of omega y', are their own variations.
        for table in 0..1 + usize::from(plan.has_velocity) {
            let mut change = vec![none; points];
            for (point, change) in change.iter_mut().enumerate() {
                *change = self.tables.row(table, point)[0];
            }
            tables.push(change);
        }
        for product in &plan.products {
            let mut change = vec![none; points];
            for (one, other) in [(product.left, product.right), (product.right, product.left)] {
                for (point, sum) in change.iter_mut().enumerate() {
                    let value = self.tables.row(other, point)[0];
                    *sum = residues.sum(*sum, residues.product(tables[one][point], value));
                }
            }
            tables.push(change);
        }
        let count = plan.harmonics(1);
        let (mut plain, mut damped) = (vec![none; count], vec![none; count]);
        for derivative in [false, true] {
            let mut values = vec![none; points];
            for ((term, (table, own)), factor) in
                plan.terms.iter().zip(&plan.of_terms).zip(coefficients)
            {
                if term.order == 1 && *own == derivative {
                    add_multiple(&residues, &mut values, *factor, &tables[*table]);
                }
            }
            let (wave, out) = match derivative {
                false => (Wave::Sine, &mut plain),
                true => (Wave::Cosine, &mut damped),
            };
            field.waves.coefficients(&residues, wave, &mut values, out);
        }
        for value in &mut plain {
            *value = residues.negative(*value);
        }
        multiply(&residues, &mut damped, &field.factors.falling);
        let slope = residues.difference(plain[plan.resonant()], damped[plan.resonant()]);
        if slope.0.contains(&0) {
            return None;
        }
        Some(Variation { tables, plain, damped, inverse_slope: residues.inverse(slope) })
    }
}

/// The series that the frequency corrections of later orders multiply: `y_n`, with its derivatives,
/// or that of the terms with one velocity.
#[derive(Clone, Copy)]
enum FrequencyFactor {
    Motion,
    Velocity,
    Damped,
}

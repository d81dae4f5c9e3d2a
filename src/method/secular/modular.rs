//! The elimination of secular terms modulo one prime, on values at points.
//!
//! The same recursion as in [the ring's own](super), with three changes that make it fast. Products of series are sums of products of
//! values at [points](crate::series::waves), `sum_i u_i v_(n-i)`, instead of products of Fourier series. A term `y^p (omega y')` is
//! the derivative of `y^(p+1)/(p+1)` and needs no values of the velocity. And everything is a [residue](crate::exact::residue), eight
//! side by side.
//!
//! Two symmetries are used, and an equation without the second is left to the ring: half-wave (every `p + q` odd: odd harmonics
//! alone), and under reversal of time, where `y_n` consists of cosines (every `q` even) or of cosines for even `n` and of sines
//! for odd `n` (every `q` as even as the order of its term).
//!
//! Cost for `P` products to order `N` with `K` harmonics: `P K N^2/2` multiplications of words (half for a square), `K N^2/6` for
//! each series that is multiplied by the frequency, and `N` transforms each way.

use std::ops::Range;

use super::sine::{Sine, SineFactors};
use super::{Amplitude, Detuning, Scheme};
use crate::exact::Rational;
use crate::exact::residue::sums::{Part, Product, combine, convolve, mixture, multiply, vary};
use crate::exact::residue::{Arithmetic, Modulus, Rows, WIDTH, padded};
use crate::series::waves::{Grid, Wave, Waves};
use crate::solution::AmplitudeConvention;

/// A term `delta^order coefficient y^position (omega y')^velocity` of the force.
#[derive(Clone, Debug)]
pub(super) struct Term {
    pub order: usize,
    pub position: u32,
    pub velocity: u32,
    pub coefficient: Rational,
}

/// What is the same for every prime: the products, their symmetries and the points they are formed at.
pub(super) struct Plan<'a> {
    pub terms: &'a [Term],
    pub scheme: Scheme,
    /// The highest order that is kept; the amplitude of a limit cycle follows from one order more.
    pub highest: usize,
    last: usize,
    pub half_wave: bool,
    /// Sines at odd orders.
    alternating: bool,
    /// How many harmonics an order brings.
    growth: usize,
    grid: Grid,
    /// The tables of values: `y`, `omega y'` where it is needed, and products of those before.
    pub tables: usize,
    pub products: Vec<Product>,
    /// Which table belongs to each term, and whether its derivative is meant.
    pub of_terms: Vec<(usize, bool)>,
    pub has_velocity: bool,
    /// Harmonics that the frequency of the last order does not depend on are left out.
    frequency_alone: bool,
    /// Where the coefficients of each order start in a list of all, and where the last ends.
    starts: Vec<usize>,
    /// A sine beside the terms, with its rate.
    pub sine: Option<(Sine, Rational)>,
}

impl<'a> Plan<'a> {
    /// `None` for an equation without the symmetry under reversal of time, and for one without terms. With `frequency_alone`
    /// nothing but the frequency is right in the image; `sine` is the rate of a [sine](super::sine) beside the terms, for a free
    /// motion.
    pub fn new(
        terms: &'a [Term],
        sine: Option<Rational>,
        highest: usize,
        scheme: Scheme,
        frequency_alone: bool,
    ) -> Option<Self> {
        let conservative = terms.iter().all(|term| term.velocity % 2 == 0);
        let alternating = terms.iter().all(|term| term.velocity as usize % 2 == term.order % 2);
        if !(conservative || alternating) || terms.iter().any(|term| term.position + term.velocity == 0) {
            return None;
        }
        let power = |term: &Term| (term.position + term.velocity) as usize;
        let half_wave = terms.iter().all(|term| power(term) % 2 == 1);
        let growths = terms.iter().map(|term| (power(term) - 1).div_ceil(term.order));
        let growth = growths.chain(sine.as_ref().map(|_| 2)).max()?;
        let determined = scheme.amplitude == Amplitude::Determined;
        let last = highest + usize::from(determined);
        // The frequency of a limit cycle is the same however its motion is normalised, and without the sum over all harmonics
        // that the initial value is, the high ones are not needed. That of a free motion belongs to one amplitude or the other.
        let frequency_alone =
            frequency_alone && (determined || scheme.normalisation == AmplitudeConvention::FirstHarmonic);
        let normalisation = match frequency_alone {
            true => AmplitudeConvention::FirstHarmonic,
            false => scheme.normalisation,
        };
        let mut plan = Self {
            terms,
            scheme: Scheme {
                normalisation,
                ..scheme
            },
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
            starts: vec![0],
            sine: None,
        };
        for order in 0..=last {
            plan.starts.push(plan.starts[order] + padded(plan.harmonics(order)));
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

    fn table_of(&mut self, term: &Term) -> (usize, bool) {
        let needed = self.last.saturating_sub(term.order);
        match (term.position, term.velocity) {
            (position, 0) => (self.power(0, position, needed), false),
            (position, 1) => (self.power(0, position + 1, needed), true),
            (0, velocity) => (self.power(1, velocity, needed), false),
            (position, velocity) => {
                let (position, velocity) = (self.power(0, position, needed), self.power(1, velocity, needed));
                (self.product(position, velocity, needed), false)
            }
        }
    }

    /// By steps of two, so that neighbouring powers share their work.
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
        let known = self
            .products
            .iter_mut()
            .find(|known| (known.left, known.right) == (left, right));
        if let Some(known) = known {
            known.needed = known.needed.max(needed);
            return known.to;
        }
        let to = self.tables;
        self.tables += 1;
        self.products.push(Product {
            left,
            right,
            to,
            needed,
        });
        to
    }

    /// How many harmonics `y_order` has at most: `1, 3, ...` or `0, 1, 2, ...`.
    fn reach(&self, order: usize) -> usize {
        match self.half_wave {
            true => order * self.growth / 2 + 1,
            false => order * self.growth + 2,
        }
    }

    /// How many harmonics of `y_order` are computed. An order changes a harmonic by no more than it reaches, so that what the
    /// first harmonic of the last order depends on is below what is left to come.
    pub fn harmonics(&self, order: usize) -> usize {
        match self.frequency_alone {
            true => self.reach(order).min(self.reach(self.last - order) + 1),
            false => self.reach(order),
        }
    }

    /// The places of an order's coefficients in a list of those of all orders.
    fn places(&self, order: usize) -> Range<usize> {
        self.starts[order]..self.starts[order] + self.harmonics(order)
    }

    /// How many points tell the harmonics apart: with `K` of them, a product's index `j` is taken for `2K - 1 - j` (`2K - j` where
    /// all harmonics stand), which must be none that is computed.
    fn points(&self) -> usize {
        match self.frequency_alone {
            true => self.reach(self.last) / 2 + self.growth + 3,
            // One more than there are, for the last order is only looked at in its first harmonic.
            false => self.reach(self.last) + 1,
        }
    }

    /// The number of harmonics of the order that has the most.
    fn most_harmonics(&self) -> usize {
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

    /// What `y_order` consists of.
    pub fn wave(&self, order: usize) -> Wave {
        match self.alternating && order % 2 == 1 {
            true => Wave::Sine,
            false => Wave::Cosine,
        }
    }

    /// What a prime minus one has to be a multiple of.
    pub fn circle(&self) -> u64 {
        self.grid.circle() as u64
    }

    /// The largest divisor of the elimination at an order, `k^2 - 1`, has no prime factor above this.
    pub fn largest_factor(&self, order: usize) -> u64 {
        let highest = self.harmonic(self.reach(order) - 1) as u64 + 1;
        if self.half_wave { highest / 2 } else { highest }
    }

    /// The same for the frequency: what comes back to the first harmonic was no further away than half of the orders reach, but for
    /// the initial value of a free motion, which is a sum over all harmonics.
    pub fn largest_factor_of_frequency(&self, order: usize) -> u64 {
        let free = self.scheme.amplitude == Amplitude::Free;
        match free && self.scheme.normalisation == AmplitudeConvention::Initial {
            true => self.largest_factor(order),
            false => self.largest_factor(order / 2),
        }
    }

    /// The first order, counted in steps from `start`, at which eight harmonics are not all zero.
    fn first(&self, block: usize, start: usize, step: usize) -> usize {
        let index = block * WIDTH;
        let order = match self.half_wave {
            true => (2 * index).div_ceil(self.growth.max(1)),
            false => index.saturating_sub(1).div_ceil(self.growth.max(1)),
        };
        order.saturating_sub(start) / step
    }
}

/// What one prime sees: plain residues, order by order.
pub(super) struct Image {
    pub modulus: Modulus,
    /// The coefficients of the harmonics of `y_n` from the order on that is wanted from this prime.
    displacement: Vec<u64>,
    /// Where the first of them stands among those of all orders.
    start: usize,
    /// `W_n`.
    pub frequency_squared: Vec<u64>,
    /// `omega_n`.
    pub frequency: Vec<u64>,
}

impl Image {
    /// The coefficients of an order; empty where nobody wants them from this prime.
    pub fn displacement(&self, plan: &Plan, order: usize) -> &[u64] {
        let places = plan.places(order);
        let Some(start) = places.start.checked_sub(self.start) else {
            return &[];
        };
        self.displacement.get(start..places.end - self.start).unwrap_or(&[])
    }
}

/// The recursion modulo one prime after the other, in the same memory.
pub(super) struct Recursion<'a, A> {
    arithmetic: A,
    plan: &'a Plan<'a>,
    /// Values at the points, an entry for each order.
    tables: Vec<Rows>,
    /// Coefficients of the harmonics: of `y_n''` or `-y_n`, of `y_n'`, and of the derivative of all terms with one velocity.
    detuned: Rows,
    derived: Rows,
    damped: Rows,
    /// The coefficients of all orders at their [places](Plan::places).
    motion: Vec<u64>,
    frequency_squared: Vec<u64>,
    frequency: Vec<u64>,
    of_amplitude: Option<Variation>,
    values: Vec<u64>,
    reversed: Vec<u64>,
    parts: Vec<Part>,
    right_side: Vec<u64>,
    change: Vec<u64>,
}

/// What there is of one prime before anything is expanded.
pub(super) struct Field {
    pub modulus: Modulus,
    waves: Waves,
    factors: Factors,
    /// Those of the terms, each over the power whose derivative is meant.
    pub coefficients: Vec<u64>,
    sine: Option<SineFactors>,
}

impl Field {
    /// `None` where a divisor is a multiple of the prime.
    pub fn new(plan: &Plan, modulus: Modulus) -> Option<Self> {
        let coefficient = |(term, (_, derivative)): (&Term, &(usize, bool))| {
            let (numerator, denominator) = (term.coefficient.numer(), term.coefficient.denom());
            let power = if *derivative { i64::from(term.position) + 1 } else { 1 };
            let divisor = modulus.product(modulus.integer(denominator), modulus.small(power));
            (divisor != 0).then(|| modulus.product(modulus.integer(numerator), modulus.inverse(divisor)))
        };
        let pairs = plan.terms.iter().zip(&plan.of_terms);
        Some(Self {
            modulus,
            waves: Waves::new(&modulus, plan.grid)?,
            factors: Factors::new(&modulus, plan)?,
            coefficients: pairs.map(coefficient).collect::<Option<_>>()?,
            sine: match &plan.sine {
                Some((_, rate)) => Some(SineFactors::new(&modulus, rate, plan.last)?),
                None => None,
            },
        })
    }
}

/// What the coefficients of the harmonics are multiplied by, one by one.
struct Factors {
    /// `1/(1 - k^2)`, zero for the first harmonic.
    solution: Vec<u64>,
    /// `-k^2`, or minus one where the frequency stands before `y`.
    detuning: Vec<u64>,
    /// `k`: from sines to the cosines of their derivative.
    rising: Vec<u64>,
    /// `-k`: from cosines to sines.
    falling: Vec<u64>,
}

impl Factors {
    fn new(modulus: &Modulus, plan: &Plan) -> Option<Self> {
        let count = plan.most_harmonics();
        let first = modulus.small(plan.harmonic(0) as i64);
        let step = modulus.small((plan.harmonic(1) - plan.harmonic(0)) as i64);
        let harmonics = std::iter::successors(Some(first), |harmonic| Some(modulus.sum(*harmonic, step)));
        let mut rising: Vec<u64> = harmonics.take(count).collect();
        rising.resize(padded(count), 0);
        let negative = |values: &[u64]| -> Vec<u64> { values.iter().map(|value| modulus.negative(*value)).collect() };
        let squares: Vec<u64> = rising.iter().map(|k| modulus.product(*k, *k)).collect();
        let divisor = |square: &u64| modulus.difference(modulus.one, *square);
        let mut solution: Vec<u64> = squares.iter().map(divisor).collect();
        solution[plan.resonant()] = modulus.one;
        modulus.invert(&mut solution[..count])?;
        solution[plan.resonant()] = 0;
        solution[count..].fill(0);
        Some(Self {
            solution,
            detuning: match plan.scheme.detuning {
                Detuning::Acceleration => negative(&squares),
                Detuning::Displacement => {
                    let mut minus = vec![modulus.negative(modulus.one); count];
                    minus.resize(padded(count), 0);
                    minus
                }
            },
            falling: negative(&rising),
            rising,
        })
    }

    /// For the derivative of a sum of these waves.
    fn derivative(&self, of: Wave) -> &[u64] {
        match of {
            Wave::Cosine => &self.falling,
            Wave::Sine => &self.rising,
        }
    }
}

/// How everything changes with the amplitude of `y_0`, for limit cycles.
struct Variation {
    /// Of each table, its values.
    tables: Vec<Vec<u64>>,
    /// Of the right side without the terms with one velocity, and of those.
    plain: Vec<u64>,
    damped: Vec<u64>,
    /// `1/J`.
    inverse_slope: u64,
}

impl<'a, A: Arithmetic> Recursion<'a, A> {
    /// Room for all orders.
    pub fn new(arithmetic: A, plan: &'a Plan) -> Self {
        let orders = plan.last + 1;
        let points = plan.grid.size();
        let harmonics = plan.most_harmonics();
        let table = |wanted: bool| Rows::new(if wanted { harmonics } else { 0 }, orders + 1);
        Self {
            arithmetic,
            plan,
            tables: vec![Rows::new(points, orders); plan.tables],
            detuned: table(true),
            derived: table(plan.has_velocity),
            damped: table(plan.of_terms.iter().any(|(_, derivative)| *derivative)),
            motion: vec![0; *plan.starts.last().unwrap_or(&0)],
            frequency_squared: Vec::with_capacity(orders),
            frequency: Vec::with_capacity(orders),
            of_amplitude: None,
            values: vec![0; padded(points)],
            reversed: Vec::with_capacity(orders),
            parts: Vec::with_capacity(plan.terms.len()),
            right_side: vec![0; padded(harmonics)],
            change: vec![0; padded(harmonics)],
        }
    }

    /// Everything that is wanted, modulo one prime; the motion from the order `wanted` on. `None` where a divisor is a multiple of
    /// the prime, and where a secular sine stays: the ring's own recursion says which.
    pub fn image(&mut self, prime: u64, wanted: usize) -> Option<Image> {
        let modulus = Modulus::new(prime, A::RADIX);
        let mut field = Field::new(self.plan, modulus)?;
        let coefficients = std::mem::take(&mut field.coefficients);
        self.expand(&mut field, &coefficients)?;
        let plain = |residues: &[u64]| residues.iter().map(|residue| modulus.plain(*residue)).collect();
        let start = self.plan.starts[wanted.min(self.plan.highest + 1)];
        Some(Image {
            modulus,
            displacement: plain(&self.motion[start..self.plan.starts[self.plan.highest + 1]]),
            start,
            frequency_squared: plain(&self.frequency_squared),
            frequency: plain(&self.frequency),
        })
    }

    /// `W_n` of what was expanded last, in Montgomery's form as the others.
    pub fn frequency_squared(&self) -> &[u64] {
        &self.frequency_squared
    }

    /// `omega_n`.
    pub fn frequency(&self) -> &[u64] {
        &self.frequency
    }

    /// The coefficients of the harmonics of `y_n`.
    pub fn displacement(&self, order: usize) -> &[u64] {
        &self.motion[self.plan.places(order)]
    }

    /// Expands with these coefficients of the terms.
    pub fn expand(&mut self, field: &mut Field, coefficients: &[u64]) -> Option<()> {
        let (plan, one) = (self.plan, field.modulus.one);
        self.frequency_squared.clear();
        self.frequency.clear();
        self.frequency_squared.push(one);
        self.frequency.push(one);
        self.right_side.fill(0);
        self.right_side[plan.resonant()] = one;
        self.push_displacement(field, 0);
        self.of_amplitude = match plan.scheme.amplitude {
            Amplitude::Free => None,
            Amplitude::Determined => Some(self.variation(field, coefficients)?),
        };
        for order in 1..=plan.highest {
            self.solve_order(field, coefficients, order)?;
        }
        if plan.last > plan.highest && plan.highest > 0 {
            self.form_right_side(field, coefficients, plan.last);
            self.fix_amplitude(field, plan.last);
        }
        Some(())
    }

    fn solve_order(&mut self, field: &mut Field, coefficients: &[u64], order: usize) -> Option<()> {
        self.form_right_side(field, coefficients, order);
        if order > 1 {
            self.fix_amplitude(field, order);
        }
        let (modulus, resonant) = (field.modulus, self.plan.resonant());
        let wave = self.plan.wave(order);
        let square = match wave {
            Wave::Sine if self.right_side[resonant] != 0 => return None,
            Wave::Sine => 0,
            Wave::Cosine => modulus.negative(self.right_side[resonant]),
        };
        // Of a sum over all pairs, each pair once and the middle.
        let lower = (1..order.div_ceil(2)).filter(|&i| self.frequency[i] != 0);
        let pairs = lower.fold(0, |sum, i| {
            modulus.sum(sum, modulus.product(self.frequency[i], self.frequency[order - i]))
        });
        let middle = match order % 2 {
            0 => modulus.product(self.frequency[order / 2], self.frequency[order / 2]),
            _ => 0,
        };
        let products = modulus.sum(modulus.sum(pairs, pairs), middle);
        let twice = modulus.difference(square, products);
        // Half of it: an odd one is made even by the prime.
        let half = if twice % 2 == 0 {
            twice / 2
        } else {
            twice.midpoint(modulus.prime)
        };
        self.frequency_squared.push(square);
        self.frequency.push(half);
        let count = padded(self.plan.harmonics(order));
        multiply(
            self.arithmetic,
            &modulus,
            &mut self.right_side[..count],
            &field.factors.solution,
        );
        self.normalise(field, order);
        self.push_displacement(field, order);
        Some(())
    }

    /// `r_n` as in the head of the module, in the coefficients of its harmonics.
    fn form_right_side(&mut self, field: &mut Field, coefficients: &[u64], order: usize) {
        let (arithmetic, modulus, plan) = (self.arithmetic, field.modulus, self.plan);
        let wave = plan.wave(order);
        let count = plan.harmonics(order);
        let mut right_side = std::mem::take(&mut self.right_side);
        let mut change = std::mem::take(&mut self.change);
        let used = padded(count);
        right_side[..used].fill(0);
        self.prepare_sine(field, order);
        if self.mix(field, coefficients, order, false) {
            let out = &mut right_side[..count];
            field
                .waves
                .coefficients((arithmetic, &modulus), wave, &mut self.values, out);
            out.iter_mut().for_each(|value| *value = modulus.negative(*value));
        }
        if self.mix(field, coefficients, order, true) {
            let damped = &mut change[..used];
            damped.fill(0);
            field.waves.coefficients(
                (arithmetic, &modulus),
                wave.other(),
                &mut self.values,
                &mut damped[..count],
            );
            multiply(arithmetic, &modulus, damped, field.factors.derivative(wave.other()));
            self.damped.write(self.slot(order), damped);
            if plan.scheme.detuning == Detuning::Acceleration {
                self.delayed(
                    &modulus,
                    |this| (&this.damped, &this.frequency[..]),
                    order,
                    1..order + 1,
                    damped,
                );
            }
            subtract(&modulus, &mut right_side[..used], damped);
        }
        if order > 1 {
            let detuned = &mut change[..used];
            self.delayed(
                &modulus,
                |this| (&this.detuned, &this.frequency_squared[..]),
                order,
                1..order,
                detuned,
            );
            subtract(&modulus, &mut right_side[..used], detuned);
        }
        (self.right_side, self.change) = (right_side, change);
    }

    /// The sum of all terms at an order, with a derivative or without, into `values`; whether there are any such terms.
    fn mix(&mut self, field: &Field, coefficients: &[u64], order: usize, derivative: bool) -> bool {
        let modulus = &field.modulus;
        let terms = self.plan.terms.iter().zip(&self.plan.of_terms).zip(coefficients);
        let parts = terms
            .filter(|((_, (_, own)), _)| *own == derivative)
            .filter_map(|((term, (table, _)), factor)| {
                Some(Part {
                    factor: *factor,
                    table: *table,
                    order: order.checked_sub(term.order)?,
                })
            });
        self.parts.clear();
        self.parts.extend(parts);
        if let (Some((sine, _)), Some(factors), false) = (&self.plan.sine, &field.sine, derivative) {
            self.parts.push(factors.sine(modulus, sine, order));
        }
        if !self.parts.is_empty() {
            mixture(self.arithmetic, modulus, &self.parts, &self.tables, &mut self.values);
        }
        !self.parts.is_empty()
    }

    /// The sum that `S_n` is, without its last term: nobody knows `y_n` yet.
    fn prepare_sine(&mut self, field: &Field, order: usize) {
        if let Some((sine, _)) = &self.plan.sine {
            self.values.fill(0);
            self.tables[sine.scaled].write(order, &self.values);
            let products = std::slice::from_ref(&sine.of_sine);
            convolve(self.arithmetic, &field.modulus, products, &mut self.tables, order);
        }
    }

    /// Sine and cosine at an order whose `y_n` stands in its table, the cosine of the next one too.
    fn push_sine(&mut self, field: &Field, order: usize) {
        let (Some((sine, _)), Some(factors)) = (&self.plan.sine, &field.sine) else {
            return;
        };
        let (arithmetic, modulus) = (self.arithmetic, &field.modulus);
        let whole = Part {
            factor: modulus.one,
            table: 0,
            order,
        };
        let mut form = |tables: &mut [Rows], parts: &[Part], (table, order): (usize, usize)| {
            mixture(arithmetic, modulus, parts, tables, &mut self.values);
            tables[table].write(order, &self.values);
        };
        let tables = &mut self.tables[..];
        form(tables, &[factors.scaled(modulus, order)], (sine.scaled, order));
        match order {
            0 => {
                form(tables, &[whole], (sine.sine, 0));
                self.values.fill(modulus.one);
                tables[sine.cosine].write(0, &self.values);
            }
            _ => form(tables, &[factors.sine(modulus, sine, order), whole], (sine.sine, order)),
        }
        convolve(
            arithmetic,
            modulus,
            std::slice::from_ref(&sine.of_cosine),
            tables,
            order,
        );
        if order < self.plan.last {
            mixture(
                arithmetic,
                modulus,
                &[factors.cosine(modulus, sine, order)],
                tables,
                &mut self.values,
            );
            tables[sine.cosine].write(order + 1, &self.values);
        }
    }

    /// Where an order stands among the coefficients: those of the same symmetry side by side.
    fn slot(&self, order: usize) -> usize {
        match self.plan.alternating {
            true => order / 2 + order % 2 * (self.plan.last / 2 + 1),
            false => order,
        }
    }

    /// `out = sum over i in range of frequency_(order-i) series_i`, where orders of the other symmetry are zero.
    fn delayed(
        &mut self,
        modulus: &Modulus,
        series: impl Fn(&Self) -> (&Rows, &[u64]),
        order: usize,
        range: Range<usize>,
        out: &mut [u64],
    ) {
        let step = if self.plan.alternating { 2 } else { 1 };
        let start = match self.plan.alternating {
            true => range.start + (order + range.start) % 2,
            false => range.start,
        };
        let mut reversed = std::mem::take(&mut self.reversed);
        let (rows, frequency) = series(self);
        reversed.clear();
        reversed.extend((start..range.end).step_by(step).map(|i| frequency[order - i]));
        let first = |block| self.plan.first(block, start, step);
        let table = (rows, self.slot(start));
        combine(self.arithmetic, modulus, &reversed, table, first, out);
        self.reversed = reversed;
    }

    /// Chooses the amplitude of `y_(order-1)` so that the right side of `order` has no secular sine.
    fn fix_amplitude(&mut self, field: &Field, order: usize) {
        let Some(variation) = &self.of_amplitude else { return };
        let (modulus, plan, resonant) = (field.modulus, self.plan, self.plan.resonant());
        let right_side = &mut self.right_side[..];
        if plan.wave(order) == Wave::Cosine || right_side[resonant] == 0 {
            return;
        }
        let secular = modulus.negative(right_side[resonant]);
        let amplitude = modulus.product(secular, variation.inverse_slope);
        for (table, change) in self.tables.iter_mut().zip(&variation.tables) {
            vary(self.arithmetic, &modulus, (table, order - 1), amplitude, change);
        }
        add_multiple(&modulus, right_side, amplitude, &variation.plain);
        add_multiple(&modulus, right_side, modulus.negative(amplitude), &variation.damped);
        let before = self.slot(order - 1);
        let first = &mut self.motion[plan.starts[order - 1] + resonant];
        *first = modulus.sum(*first, amplitude);
        let first = *first;
        let detuned = modulus.product(first, field.factors.detuning[resonant]);
        self.detuned.set(resonant, before, detuned);
        if plan.has_velocity {
            self.derived.set(resonant, before, modulus.negative(first));
        }
        let slot = self.slot(order);
        if self.damped.blocks() > 0 {
            for (index, change) in variation.damped.iter().enumerate() {
                let changed = modulus.sum(self.damped.get(index, slot), modulus.product(amplitude, *change));
                self.damped.set(index, slot, changed);
            }
        }
    }

    /// Adds to the solution of an order the homogeneous one that the amplitude convention asks for.
    fn normalise(&mut self, field: &Field, order: usize) {
        if self.plan.scheme.normalisation == AmplitudeConvention::FirstHarmonic {
            return;
        }
        let modulus = &field.modulus;
        let displacement = &mut self.right_side[..self.plan.harmonics(order)];
        let at_zero = match (self.plan.wave(order), self.plan.scheme.amplitude) {
            (Wave::Sine, _) => displacement
                .iter()
                .zip(&field.factors.rising)
                .fold(0, |sum, (value, k)| modulus.sum(sum, modulus.product(*value, *k))),
            (Wave::Cosine, Amplitude::Free) => displacement.iter().fold(0, |sum, value| modulus.sum(sum, *value)),
            (Wave::Cosine, Amplitude::Determined) => return,
        };
        displacement[self.plan.resonant()] = modulus.negative(at_zero);
    }

    /// Takes what stands in `right_side` for `y_n`.
    fn push_displacement(&mut self, field: &mut Field, order: usize) {
        let (arithmetic, modulus, plan) = (self.arithmetic, field.modulus, self.plan);
        let (wave, count, slot) = (plan.wave(order), plan.harmonics(order), self.slot(order));
        let used = padded(count);
        let displacement = &self.right_side[..used];
        self.motion[plan.starts[order]..][..used].copy_from_slice(displacement);
        field
            .waves
            .values((arithmetic, &modulus), wave, &displacement[..count], &mut self.values);
        self.tables[0].write(order, &self.values);
        let mut change = std::mem::take(&mut self.change);
        change[..used].copy_from_slice(displacement);
        multiply(arithmetic, &modulus, &mut change[..used], &field.factors.detuning);
        self.detuned.write(slot, &change[..used]);
        if plan.has_velocity {
            let velocity = &mut change[..used];
            velocity.copy_from_slice(displacement);
            multiply(arithmetic, &modulus, velocity, field.factors.derivative(wave));
            self.derived.write(slot, velocity);
            if plan.scheme.detuning == Detuning::Acceleration {
                self.delayed(
                    &modulus,
                    |this| (&this.derived, &this.frequency[..]),
                    order,
                    0..order + 1,
                    velocity,
                );
            }
            field.waves.values(
                (arithmetic, &modulus),
                wave.other(),
                &velocity[..count],
                &mut self.values,
            );
            self.tables[1].write(order, &self.values);
        }
        self.change = change;
        convolve(arithmetic, &modulus, &plan.products, &mut self.tables, order);
        self.push_sine(field, order);
    }

    /// The first variation at order zero; `None` where the secular sine does not depend on the amplitude.
    fn variation(&mut self, field: &mut Field, coefficients: &[u64]) -> Option<Variation> {
        let (arithmetic, modulus, plan) = (self.arithmetic, field.modulus, self.plan);
        let start: Vec<Vec<u64>> = self.tables.iter().map(|table| table.read(0)).collect();
        // Of y and of omega y': themselves.
        let leaves = 1 + usize::from(plan.has_velocity);
        let mut tables: Vec<Vec<u64>> = start[..leaves].to_vec();
        for product in &plan.products {
            let mut change = vec![0; self.values.len()];
            for (one, other) in [(product.left, product.right), (product.right, product.left)] {
                for ((sum, varied), value) in change.iter_mut().zip(&tables[one]).zip(&start[other]) {
                    *sum = modulus.sum(*sum, modulus.product(*varied, *value));
                }
            }
            tables.push(change);
        }
        let count = plan.harmonics(1);
        let mut changes = [(Wave::Sine, false), (Wave::Cosine, true)].map(|(wave, derivative)| {
            let mut values = vec![0; self.values.len()];
            let terms = plan.terms.iter().zip(&plan.of_terms).zip(coefficients);
            for ((_, (table, _)), coefficient) in
                terms.filter(|((term, (_, own)), _)| term.order == 1 && *own == derivative)
            {
                add_multiple(&modulus, &mut values, *coefficient, &tables[*table]);
            }
            let mut change = vec![0; padded(count)];
            let out = &mut change[..count];
            field.waves.coefficients((arithmetic, &modulus), wave, &mut values, out);
            change
        });
        let [plain, damped] = &mut changes;
        plain.iter_mut().for_each(|value| *value = modulus.negative(*value));
        multiply(arithmetic, &modulus, damped, &field.factors.falling);
        let slope = modulus.difference(plain[plan.resonant()], damped[plan.resonant()]);
        let [plain, damped] = changes;
        (slope != 0).then(|| Variation {
            tables,
            plain,
            damped,
            inverse_slope: modulus.inverse(slope),
        })
    }
}

fn subtract(modulus: &Modulus, values: &mut [u64], others: &[u64]) {
    for (value, other) in values.iter_mut().zip(others) {
        *value = modulus.difference(*value, *other);
    }
}

fn add_multiple(modulus: &Modulus, sums: &mut [u64], factor: u64, values: &[u64]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum = modulus.sum(*sum, modulus.product(factor, *value));
    }
}

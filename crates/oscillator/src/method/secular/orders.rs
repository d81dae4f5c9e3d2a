//! The orders of an expansion as its lists of series.

use num_traits::Zero;

use super::fixed_width;
use super::plan::Plan;
use super::reconstruct::ExpansionScope;
use super::{AmplitudeKind, SecularExpansion, SecularSine};
use crate::exact::{Integer, Integers, Rational};
use crate::series::FourierSeries;
use crate::series::fixed_width::{FixedWidth, ShortFraction, ShortSeries};
use crate::series::waves::Wave;

/// One order of the result.
pub(super) struct ExpansionOrder {
    pub displacement: FourierSeries<Integers>,
    /// The coefficient of `cos tau`, used for limit cycles only.
    pub first_harmonic: Rational,
    pub frequency_squared: Rational,
    pub frequency: Rational,
}

impl ExpansionOrder {
    /// Converts an order from numbers of fixed width; `None` if it is not among them.
    pub fn of_short(plan: &Plan, order: usize, orders: &fixed_width::FirstOrders) -> Option<Self> {
        let motion = orders.displacement.get(order).filter(|_| order < orders.count)?;
        let first = match (motion.wave(), plan.scheme.amplitude) {
            (Wave::Cosine, AmplitudeKind::Determined) => motion.coefficient(plan.resonant()),
            _ => None,
        };
        let numerators = motion.numerators().iter().copied().map(Integer::from);
        Some(Self {
            displacement: motion_of_order(plan, order, motion.denominator().into(), numerators),
            first_harmonic: first.map_or_else(Rational::zero, rational),
            frequency_squared: rational(orders.frequency_squared[order]),
            frequency: rational(orders.frequency[order]),
        })
    }
}

/// All orders of an expansion in numbers of fixed width; `slope` is that of the secular sine in the
/// amplitude.
pub(super) fn short_expansion<W: FixedWidth>(
    plan: &Plan,
    orders: &fixed_width::FirstOrders<W>,
    slope: Option<&Rational>,
    extent: ExpansionScope,
) -> SecularExpansion<Integers> {
    let constant = |own: ShortFraction<W>| match own.is_zero() {
        true => FourierSeries::zero(Integers),
        false => {
            let numerator = vec![own.numerator().into()];
            FourierSeries::in_lowest_terms(Integers, own.denominator().into(), numerator, vec![])
        }
    };
    let constants = |all: &[ShortFraction<W>]| {
        let mut constants = Vec::with_capacity(orders.count);
        constants.extend(all.iter().take(orders.count).copied().map(constant));
        constants
    };
    let motions =
        (0..orders.count).filter_map(|order| Some((order, orders.displacement.get(order)?)));
    let first_harmonic = |motion: ShortSeries<W>| match motion.wave() {
        Wave::Cosine => motion.coefficient(plan.resonant()).unwrap_or_else(ShortFraction::zero),
        Wave::Sine => ShortFraction::zero(),
    };
    let condition = |slope: &Rational| {
        let condition = |first_harmonic: ShortFraction<W>| match orders
            .slope
            .and_then(|slope| first_harmonic.product(slope))
        {
            Some(product) => SecularSine {
                sine: constant(product.negative()),
                slope: self::constant(slope.clone()),
                amplitude: constant(first_harmonic),
            },
            None => secular_sine(rational(first_harmonic), slope),
        };
        let motions = motions.clone().skip(1);
        motions.map(|(_, motion)| condition(first_harmonic(motion))).collect()
    };
    let displacement = |(order, motion): (usize, ShortSeries<W>)| {
        let numerators = motion.numerators().iter().map(|own| (*own).into());
        motion_of_order(plan, order, motion.denominator().into(), numerators)
    };
    SecularExpansion {
        frequency_squared: constants(&orders.frequency_squared),
        frequency: constants(&orders.frequency),
        amplitudes: slope.map(condition).unwrap_or_default(),
        displacement: match extent {
            ExpansionScope::Motion => {
                let mut all = Vec::with_capacity(orders.count);
                all.extend(motions.map(displacement));
                all
            }
            ExpansionScope::Frequency => vec![],
        },
    }
}

/// A fraction of fixed width as one of any length.
pub(super) fn rational<W: FixedWidth>(own: ShortFraction<W>) -> Rational {
    Rational::new_raw(own.numerator().into(), own.denominator().into())
}

/// The condition of an amplitude, which is the first harmonic of a limit cycle.
fn secular_sine(first_harmonic: Rational, slope: &Rational) -> SecularSine<Integers> {
    SecularSine {
        sine: constant(-(&first_harmonic * slope)),
        slope: constant(slope.clone()),
        amplitude: constant(first_harmonic),
    }
}

/// A number as a constant series.
fn constant(value: Rational) -> FourierSeries<Integers> {
    match value.is_zero() {
        true => FourierSeries::zero(Integers),
        false => {
            let (numerator, denominator) = value.into_raw();
            FourierSeries::in_lowest_terms(Integers, denominator, vec![numerator], vec![])
        }
    }
}

/// The motion of an order from the numerators of its harmonics over a denominator, in lowest terms.
pub(super) fn motion_of_order(
    plan: &Plan,
    order: usize,
    denominator: Integer,
    numerators: impl IntoIterator<Item = Integer, IntoIter: ExactSizeIterator>,
) -> FourierSeries<Integers> {
    let numerators = numerators.into_iter();
    let mut coefficients = Vec::with_capacity(plan.harmonic(numerators.len()));
    match plan.half_wave {
        true => numerators.for_each(|own| coefficients.extend([Integer::zero(), own])),
        false => coefficients.extend(numerators),
    }
    let (cosine, sine) = match plan.wave(order) {
        Wave::Cosine => (coefficients, vec![]),
        Wave::Sine => (vec![], coefficients),
    };
    FourierSeries::in_lowest_terms(Integers, denominator, cosine, sine)
}

/// The orders as series; `slope` is that of the secular sine in the amplitude.
pub(super) fn expansion(
    orders: Vec<ExpansionOrder>,
    slope: Option<&Rational>,
    extent: ExpansionScope,
) -> SecularExpansion<Integers> {
    let mut expansion = SecularExpansion {
        frequency_squared: Vec::with_capacity(orders.len()),
        frequency: Vec::with_capacity(orders.len()),
        displacement: Vec::with_capacity(orders.len()),
        amplitudes: vec![],
    };
    for (order, own) in orders.into_iter().enumerate() {
        // The first harmonic of a limit cycle is the amplitude that its secular sine has fixed.
        if let Some(slope) = slope.filter(|_| order > 0) {
            expansion.amplitudes.push(secular_sine(own.first_harmonic, slope));
        }
        expansion.frequency_squared.push(constant(own.frequency_squared));
        expansion.frequency.push(constant(own.frequency));
        if extent == ExpansionScope::Motion {
            expansion.displacement.push(own.displacement);
        }
    }
    expansion
}

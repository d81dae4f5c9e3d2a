//! The orders of an expansion as its lists of series.

use num_traits::Zero;

use super::fixed_width;
use super::plan::Plan;
use super::reconstruct::ExpansionScope;
use super::{AmplitudeKind, SecularExpansion, SecularSine};
use crate::exact::{Integer, Integers, Rational};
use crate::series::FourierSeries;
use crate::series::fixed_width::ShortFraction;
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
    /// Converts an order from numbers of fixed width.
    pub fn of_short(plan: &Plan, order: usize, own: &fixed_width::FixedWidthOrder) -> Self {
        let constant = |own: ShortFraction| {
            Rational::new_raw(own.numerator().into(), own.denominator().into())
        };
        let motion = &own.displacement;
        let first = match (motion.wave, plan.scheme.amplitude) {
            (Wave::Cosine, AmplitudeKind::Determined) => motion.coefficient(plan.resonant()),
            _ => None,
        };
        let numerators = motion.numerators().iter().copied().map(Integer::from);
        Self {
            displacement: motion_of_order(plan, order, motion.denominator().into(), numerators),
            first_harmonic: first.map_or_else(Rational::zero, constant),
            frequency_squared: constant(own.frequency_squared),
            frequency: constant(own.frequency),
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
    for (index, numerator) in numerators.enumerate() {
        coefficients.resize(plan.harmonic(index), Integer::zero());
        coefficients.push(numerator);
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
    let constant = |value: Rational| match value.is_zero() {
        true => FourierSeries::zero(Integers),
        false => {
            let (numerator, denominator) = value.into_raw();
            FourierSeries::in_lowest_terms(Integers, denominator, vec![numerator], vec![])
        }
    };
    let mut expansion = SecularExpansion {
        frequency_squared: Vec::with_capacity(orders.len()),
        frequency: Vec::with_capacity(orders.len()),
        displacement: Vec::with_capacity(orders.len()),
        amplitudes: vec![],
    };
    for (order, own) in orders.into_iter().enumerate() {
        // The first harmonic of a limit cycle is the amplitude that its secular sine has fixed.
        if let Some(slope) = slope.filter(|_| order > 0) {
            expansion.amplitudes.push(SecularSine {
                sine: constant(-(&own.first_harmonic * slope)),
                slope: constant(slope.clone()),
                amplitude: constant(own.first_harmonic),
            });
        }
        expansion.frequency_squared.push(constant(own.frequency_squared));
        expansion.frequency.push(constant(own.frequency));
        if extent == ExpansionScope::Motion {
            expansion.displacement.push(own.displacement);
        }
    }
    expansion
}

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
    /// The common denominator of all coefficients of the motion, in lowest terms.
    pub denominator: Integer,
    pub displacement: Vec<Integer>,
    /// The coefficient of `cos tau`, used for limit cycles only.
    pub first_harmonic: Rational,
    pub frequency_squared: Rational,
    pub frequency: Rational,
}

impl ExpansionOrder {
    /// Converts an order from numbers of fixed width.
    pub fn of_short(plan: &Plan, order: &fixed_width::FixedWidthOrder) -> Self {
        let constant = |own: ShortFraction| {
            Rational::new_raw(own.numerator().into(), own.denominator().into())
        };
        let motion = &order.displacement;
        let first = match (motion.wave, plan.scheme.amplitude) {
            (Wave::Cosine, AmplitudeKind::Determined) => motion.coefficient(plan.resonant()),
            _ => None,
        };
        Self {
            denominator: motion.denominator().into(),
            displacement: motion.numerators().iter().copied().map(Integer::from).collect(),
            first_harmonic: first.map_or_else(Rational::zero, constant),
            frequency_squared: constant(order.frequency_squared),
            frequency: constant(order.frequency),
        }
    }
}

/// The orders as series; `slope` is that of the secular sine in the amplitude.
pub(super) fn expansion(
    plan: &Plan,
    orders: Vec<ExpansionOrder>,
    slope: Option<&Rational>,
    extent: ExpansionScope,
) -> SecularExpansion<Integers> {
    let constant = |value: &Rational| match value.is_zero() {
        true => FourierSeries::zero(Integers),
        false => FourierSeries::in_lowest_terms(
            Integers,
            value.denom().clone(),
            vec![value.numer().clone()],
            vec![],
        ),
    };
    let series = |order: usize, denominator: Integer, numerators: Vec<Integer>| {
        let mut coefficients = Vec::with_capacity(plan.harmonic(numerators.len()));
        for (index, numerator) in numerators.into_iter().enumerate() {
            coefficients.resize(plan.harmonic(index), Integer::zero());
            coefficients.push(numerator);
        }
        let (cosine, sine) = match plan.wave(order) {
            Wave::Cosine => (coefficients, vec![]),
            Wave::Sine => (vec![], coefficients),
        };
        FourierSeries::in_lowest_terms(Integers, denominator, cosine, sine)
    };
    let frequency_squared: Vec<_> =
        orders.iter().map(|order| constant(&order.frequency_squared)).collect();
    let frequency = orders.iter().map(|order| constant(&order.frequency)).collect();
    let squares = orders.iter().skip(1).map(|order| &order.frequency_squared);
    let removed = squares.map(|square| constant(&-square)).collect();
    // The first harmonic of a limit cycle is the amplitude that its secular sine has fixed.
    let amplitudes = slope.map_or_else(Vec::new, |slope| {
        let secular_sine = |own: &ExpansionOrder| SecularSine {
            sine: constant(&-(&own.first_harmonic * slope)),
            slope: constant(slope),
            amplitude: constant(&own.first_harmonic),
        };
        orders.iter().skip(1).map(secular_sine).collect()
    });
    let mut expansion = SecularExpansion {
        frequency_squared,
        frequency,
        displacement: vec![],
        removed: vec![],
        amplitudes,
    };
    if extent == ExpansionScope::Motion {
        expansion.removed = removed;
        let orders = orders.into_iter().enumerate();
        expansion.displacement =
            orders.map(|(order, own)| series(order, own.denominator, own.displacement)).collect();
    }
    expansion
}

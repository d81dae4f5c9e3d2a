//! Symbols that a derivation by multiple scales introduces: the complex amplitude, the slow phase,
//! the orders.

use num_traits::Zero as _;

use super::slow_times::ComplexAmplitude;
use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, Rational};
use crate::solution::AmplitudeConvention;
use crate::symbol::{Symbol, fresh, fresh_stem};

/// The symbols.
pub(super) struct ExpansionSymbols {
    pub(super) complex: ComplexAmplitude,
    /// The symbol that marks the orders: the small parameter, or a symbol whose value is one.
    pub(super) marker: Symbol,
    /// The slow phase.
    pub(super) phase: Symbol,
    pub(super) amplitude: Symbol,
    /// The imaginary unit.
    pub(super) unit: Symbol,
    /// The stems of the names of the orders of the motion, and of the rates of `B` on the times.
    pub(super) orders: [String; 2],
}

impl ExpansionSymbols {
    pub(super) fn new(taken: &[Symbol], coordinate: Symbol, marker: Option<Symbol>) -> Self {
        let own = fresh("B", taken);
        Self {
            unit: fresh("i", taken),
            orders: [coordinate, own].map(|name| fresh_stem(name.name(), taken)),
            complex: ComplexAmplitude { own, conjugate: fresh("Bc", taken) },
            marker: marker.unwrap_or_else(|| fresh("delta", taken)),
            phase: fresh("psi", taken),
            amplitude: AmplitudeConvention::FirstHarmonic.symbol(),
        }
    }

    pub(super) fn mark(&self, order: usize) -> Monomial {
        Monomial::power_of(self.marker, i32::try_from(order).unwrap_or(i32::MAX))
    }

    /// A polynomial with `B` and its conjugate as `a/2`.
    pub(super) fn polar(&self, polynomial: &Polynomial) -> Polynomial {
        let mut result = Polynomial::zero();
        for (monomial, number) in polynomial.terms() {
            let exponent =
                monomial.exponent(self.complex.own) + monomial.exponent(self.complex.conjugate);
            let rest = monomial.without(self.complex.own).without(self.complex.conjugate);
            let halves = Rational::new(1.into(), 2.into()).pow(exponent);
            result.add_term(
                rest.product(&Monomial::power_of(self.amplitude, exponent)),
                number * halves,
            );
        }
        result
    }
}

//! The slow equations of a free motion, and the amplitude of the limit cycle on which it may end.

use num_traits::Zero as _;

use super::names::ExpansionSymbols;
use super::scaling::Scaling;
use super::slow_times::MultipleScalesExpansion;
use crate::exact::Polynomial;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::method::limit_cycle::{AmplitudeEquation, Cycle, FrequencyUnits, chosen};
use crate::method::{Options, Reason, Refusal};
use crate::symbol::{Symbol, fresh};

/// `a'` and `theta'` in powers of the marker.
pub(super) struct SlowEquations {
    pub(super) amplitude: Polynomial,
    pub(super) phase: Polynomial,
}

impl SlowEquations {
    pub(super) fn new(
        expansion: &MultipleScalesExpansion,
        linear_frequency: &Polynomial,
        names: &ExpansionSymbols,
    ) -> Self {
        let (mut amplitude, mut phase) = (Polynomial::zero(), linear_frequency.clone());
        let two = Polynomial::constant(ratio(2, 1));
        for (k, rate) in expansion.rates.iter().enumerate().skip(1) {
            let mark = names.mark(k);
            let polar = |part: &Polynomial| names.polar(part).product(&two).times_monomial(&mark);
            amplitude.accumulate(&polar(&rate.real));
            let over = Monomial::power_of(names.amplitude, -1);
            phase.accumulate(&polar(&rate.imaginary).times_monomial(&over));
        }
        Self { amplitude, phase }
    }

    /// The amplitude at which `a' = 0`, in powers of the marker; `None` if it needs a quotient that
    /// is not a polynomial.
    pub(super) fn at_cycle(
        &self,
        cycle: &Cycle,
        linear_frequency: &Polynomial,
        order: usize,
        names: &ExpansionSymbols,
    ) -> Option<Polynomial> {
        let mut amplitude = cycle.unit.clone();
        let coefficient = |polynomial: &Polynomial, order: usize| {
            let mut found = Polynomial::zero();
            for (monomial, number) in polynomial.terms() {
                if monomial.exponent(names.marker) == order as i32 {
                    found.add_term(monomial.without(names.marker), number.clone());
                }
            }
            found
        };
        let first = coefficient(&self.amplitude, 1).slope(names.amplitude);
        let first = first.substitute(names.amplitude, &amplitude)?;
        let inverse = match (cycle.reduced(&first).power(-1), &cycle.inverse_slope) {
            (Some(inverse), _) => inverse,
            // f_1' = -omega0 J/2
            (None, Some(inverse)) => {
                let frequency = linear_frequency.power(-1)?;
                inverse.product(&frequency).product(&Polynomial::constant(ratio(-2, 1)))
            }
            (None, None) => return None,
        };
        for k in 1..=order {
            let rate = self.amplitude.substitute(names.amplitude, &amplitude)?;
            let mut missing = cycle.reduced(&coefficient(&rate, k + 1).product(&inverse));
            missing.negate();
            amplitude.accumulate(&missing.times_monomial(&names.mark(k)));
        }
        Some(amplitude)
    }
}

/// The limit cycles of a self-excited equation, and the number of the one asked for.
pub(super) struct Cycles {
    pub(super) equation: AmplitudeEquation,
    pub(super) cycles: Vec<Cycle>,
    pub(super) number: usize,
}

/// The limit cycles of an equation whose amplitude is not free; `None` if it has none.
///
/// # Errors
/// The amplitudes have no closed form, or the cycle asked for does not exist.
pub(super) fn cycles(
    scaling: &Scaling,
    units: &FrequencyUnits,
    options: &Options,
    taken: &[Symbol],
) -> Result<Option<Cycles>, Refusal> {
    let without = match options.cycle {
        Some(asked) => Err(Reason::NoSuchCycle(asked, 0).into()),
        None => Ok(None),
    };
    let (Some(equation), Some(marker)) =
        (AmplitudeEquation::new(&scaling.force, units), scaling.marker)
    else {
        return without;
    };
    let refused = |reason| {
        let equation = equation.in_square(fresh("z", taken));
        Refusal::from(Reason::LimitCycle { equation, reason })
    };
    let cycles = equation.cycles(marker, &units.frequency, taken).map_err(refused)?;
    if cycles.is_empty() {
        return without;
    }
    let none = || Reason::NoSuchCycle(0, 0).into();
    let number = chosen(&cycles, options.cycle, none)?;
    if cycles[number - 1].attracts_where.is_none() {
        return Err(refused("a multiple root: no expansion in powers begins there"));
    }
    Ok(Some(Cycles { equation, cycles, number }))
}

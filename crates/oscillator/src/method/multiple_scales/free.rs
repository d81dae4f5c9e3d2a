//! Free motions: the slow equations, in the amplitude alone, and their solution from a start if it
//! has a closed form; for a self-excited equation also the limit cycle.

use num_traits::Zero as _;

use super::answer::{MultipleScalesResult, solution};
use super::derivation::{derivation, motion_of};
use super::names::ExpansionSymbols;
use super::release::release;
use super::scaling::{Scaling, scaling};
use super::slow_equations::{Cycles, SlowEquations, cycles};
use super::slow_times::ScaledProblem;
use super::undriven;
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials};
use crate::expr::Expr;
use crate::method::limit_cycle::FrequencyUnits;
use crate::method::lindstedt_poincare::{LinearPart, with_square};
use crate::method::{Options, Reason, Refusal, transient};
use crate::oscillator::{Oscillator, Parts};
use crate::series::FourierSeries;
use crate::solution::modulation::Release;
use crate::solution::{Definition, Law, LimitCycle, Modulation, Note, Solution};
use crate::symbol::{Symbol, fresh};

/// Default and highest orders in a parameter and in the amplitude, of which an odd force uses only
/// the even ones.
const DEFAULT: [u32; 2] = [2, 4];
const HIGHEST: [u32; 2] = [3, 6];

/// The slow equations of a free motion and what follows from them.
///
/// # Errors
/// A force that cannot be expanded, an order above the highest, or a limit cycle without a closed
/// form.
pub(super) fn solve(
    oscillator: &Oscillator,
    parts: &Parts,
    options: &Options,
) -> Result<Solution, Refusal> {
    let mut scaling = scaling(oscillator, parts, options, DEFAULT, HIGHEST)?;
    scaling.force.write_with_frequency(&oscillator.names());
    let linear = LinearPart::new(&scaling.force, oscillator);
    let units = FrequencyUnits::new(&scaling.force, linear.frequency.clone());
    let cycles = cycles(&scaling, &units, options, &linear.taken)?;
    let names = ExpansionSymbols::new(&linear.taken, oscillator.coordinate, scaling.marker);
    let order = scaling.order as usize;
    let scaled = ScaledProblem {
        terms: scaling.force.terms.iter().map(undriven).collect(),
        linear_frequency: linear.frequency.clone(),
        own: 1,
        detuning: None,
        forced: vec![],
        // The last correction of the amplitude of a limit cycle follows from one order more.
        order: order + usize::from(cycles.is_some()),
    };
    let expansion = scaled.expand(names.complex);
    let free = Free {
        slow: SlowEquations::new(&expansion, &linear.frequency, &names),
        motion: (0..=order)
            .map(|k| motion_of(&expansion.displacement[k], k, &names))
            .fold(FourierSeries::zero(POLYNOMIALS), |sum, term| sum.sum(&term)),
        scaling: &scaling,
        linear: &linear,
        names: &names,
    };
    let rates = [&free.slow.amplitude, &free.slow.phase].map(|rate| free.written(&free.cut(rate)));
    let rates = rates.each_ref().map(Expr::from);
    let derivation = derivation(&expansion, &scaling, &names, &linear.frequency, &rates, None)?;
    let mut found = MultipleScalesResult {
        definitions: linear.definitions.clone(),
        law: Law::Frequency(free.written(&free.cut(&free.slow.phase))),
        displacement: free.written_motion(&free.motion),
        limit_cycle: None,
        modulation: free.modulation(rates),
        validity: vec![scaling.cut_note()],
        derivation,
    };
    if let Some(cycles) = &cycles {
        free.place_on_cycle(cycles, &mut found)?;
    }
    found.definitions.extend(scaling.bookkeeping.clone());
    found.validity.extend(linear.root.clone().map(Note::Positive));
    // If the amplitude changes in time, the motion has a start.
    if !found.modulation.is_conservative() {
        free.start(&mut found, &oscillator.names());
    }
    Ok(solution(oscillator, &scaling, found))
}

/// A free motion with its slow equations, in powers of the marker.
struct Free<'a> {
    slow: SlowEquations,
    motion: FourierSeries<Polynomials>,
    scaling: &'a Scaling,
    linear: &'a LinearPart,
    names: &'a ExpansionSymbols,
}

impl Free<'_> {
    /// Truncates a polynomial after the order of the answer.
    fn cut(&self, polynomial: &Polynomial) -> Polynomial {
        polynomial.truncated(self.names.marker, self.scaling.order as i32)
    }

    /// A polynomial as the answer prints it: a marker whose value is one is left out, and even
    /// powers of a root are numbers.
    fn written(&self, polynomial: &Polynomial) -> Polynomial {
        let unmarked = self.scaling.unmarked(polynomial, self.names.marker);
        match (&self.linear.root, self.scaling.force.linear.as_number()) {
            (Some(root), Some(square)) => with_square(&unmarked, root.symbol, &square),
            _ => unmarked,
        }
    }

    fn written_motion(&self, motion: &FourierSeries<Polynomials>) -> FourierSeries<Polynomials> {
        motion.map(POLYNOMIALS, |coefficient, _| self.written(coefficient))
    }

    fn modulation(&self, [amplitude_rate, phase_rate]: [Expr; 2]) -> Modulation {
        // In powers of the amplitude only the leading rate determines a steady amplitude.
        let steady = match self.scaling.marker {
            Some(_) => vec![],
            None => transient::steady(self.names.amplitude, &self.leading_amplitude_rate()),
        };
        Modulation {
            amplitude: self.names.amplitude,
            phase: self.names.phase,
            amplitude_rate,
            phase_rate,
            small_with: self.scaling.small_with.clone(),
            resonance: None,
            release: None,
            transient: None,
            steady,
            motion: None,
        }
    }

    /// The rate of the amplitude to the lowest order at which it changes: where its terms balance,
    /// as in `mu*a/2 - a^3/8`, the damping is as small as `a^2`, as it was taken to be. A term of
    /// higher order, as in `-zeta*a + 3*zeta*a^3/8`, balances it at an amplitude that is not small,
    /// for which the expansion does not hold.
    fn leading_amplitude_rate(&self) -> Expr {
        let rate = &self.slow.amplitude;
        let lowest = rate.exponent_range(self.names.marker).map_or(0, |(lowest, _)| lowest);
        Expr::from(&self.written(&rate.truncated(self.names.marker, lowest)))
    }

    /// Restricts the motion to the chosen limit cycle; the motion in the amplitude is kept beside
    /// it.
    fn place_on_cycle(
        &self,
        cycles: &Cycles,
        found: &mut MultipleScalesResult,
    ) -> Result<(), Refusal> {
        let (scaling, names) = (self.scaling, self.names);
        let cycle = &cycles.cycles[cycles.number - 1];
        let order = scaling.order as usize;
        let at =
            self.slow.at_cycle(cycle, &self.linear.frequency, order, names).ok_or_else(|| {
                Refusal::from(Reason::LimitCycle {
                    equation: cycles.equation.in_square(fresh("z", &self.linear.taken)),
                    reason: "which divides by a sum of symbols",
                })
            })?;
        let put = |polynomial: &Polynomial| {
            let value = polynomial.substitute(names.amplitude, &at);
            let value = cycle.reduced(&self.cut(&value.unwrap_or_else(Polynomial::zero)));
            self.written(&value)
        };
        found.definitions.extend(cycle.definition.clone());
        let all = cycles.cycles.iter();
        let leading = cycle.to_leading(names.marker, scaling.small);
        let limit_cycle = LimitCycle {
            amplitude: self.written(&cycle.reduced(&self.cut(&at))),
            number: cycles.number,
            cycles: all.map(|cycle| cycle.to_leading(names.marker, scaling.small)).collect(),
            small_with: scaling.small_with.clone(),
        };
        found.modulation.steady = limit_cycle.cycles.clone();
        found.limit_cycle = Some(limit_cycle);
        found.validity.push(Note::Stability(leading));
        found.validity.extend(cycle.remark.clone());
        found.validity.extend(cycle.definition.clone().map(Note::Positive));
        let settled = self.motion.map(POLYNOMIALS, |coefficient, _| put(coefficient));
        found.modulation.motion = Some(std::mem::replace(&mut found.displacement, settled));
        found.law = Law::Frequency(put(&self.slow.phase));
        Ok(())
    }

    /// Adds the initial amplitude and phase of a motion released from rest, to the order of the
    /// slow equations, and the closed form from there.
    fn start(&self, found: &mut MultipleScalesResult, names: &[Symbol]) {
        let order = (self.scaling.order as usize).saturating_sub(1);
        let rates = [&self.slow.amplitude, &self.slow.phase];
        let begins = release(&self.motion, rates, &self.linear.frequency, self.names, order);
        let mut begins = match begins {
            Some(begins) => {
                let [amplitude, phase] =
                    begins.each_ref().map(|part| Expr::from(&self.written(part)));
                Release { amplitude, phase }
            }
            None => Release::at_start(),
        };
        let defined = found.definitions.iter().map(|definition| definition.symbol);
        let taken: Vec<Symbol> = names.iter().copied().chain(defined).collect();
        let modulation = &mut found.modulation;
        let rates = [&modulation.amplitude_rate, &modulation.phase_rate];
        let (named, transient) =
            transient::from_release(modulation.amplitude, rates, &mut begins, &taken);
        found.definitions.extend::<Vec<Definition>>(named);
        modulation.transient = transient;
        modulation.release = Some(begins);
    }
}

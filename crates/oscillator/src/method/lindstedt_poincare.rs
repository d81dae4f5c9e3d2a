//! The method of Lindstedt and Poincare: strained time, secular terms eliminated order by order.
//!
//! References: A. Lindstedt, Mem. Acad. Imp. Sci. St. Petersbourg 31 (1883); H. Poincare, *Les
//! methodes nouvelles de la mecanique celeste* II (1893); A. H. Nayfeh, *Perturbation Methods*,
//! Wiley 1973, section 3.1.
//!
//! ```text
//! x'' + omega0^2 x + sum_j delta^(a_j) c_j x^p x'^q = 0,      theta = omega t
//! x = A (y_0 + delta y_1 + ...),  omega^2 = omega0^2 (1 + delta W_1 + ...),  y_0 = cos theta
//! (omega/omega0)^2 y'' + y + sum_j delta^(a_j) C_j y^p (omega y'/omega0)^q = 0,  C_j = c_j A^(p+q-1) omega0^(q-2)
//! ```
//!
//! The expansion itself is [`secular::expand`](super::secular::expand), over whole numbers if every
//! symbol can be scaled away (Duffing depends on `eps*A^2` alone) and over polynomials otherwise.
//!
//! Self-excited equations determine their amplitude: `A` is then a root of the secular sine of the
//! first order, `sum_j C_j(A) [cos^p (-sin)^q]_sin = 0`, as [`limit_cycle`](super::limit_cycle)
//! finds it.
//!
//! Cost: that of [`secular::expand`](super::secular::expand) at order n, whose Fourier coefficients
//! are some n^2 in number with some n digits each.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::LindstedtPoincare), order: Some(2), ..Options::default() };
//! let solution = solve(&duffing, &options)?;
//! let law = solution.law.frequency().unwrap();
//! assert_eq!(law.to_string(), "1 + 3*eps*A^2/8 - 21*eps^2*A^4/256");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::collections::BTreeSet;

use num_traits::{One, Zero};

use super::expansion::{ExactSeries, expand_exactly};
use super::joint_expansion::expand_jointly;
use super::limit_cycle::{AmplitudeEquation, Cycle, FrequencyUnits, amplitude_of, chosen};
use super::linear::is_free_and_linear;
use super::secular::{AmplitudeKind, Detuning, ExpansionScope, Scheme, SecularError, bounded};
use super::{Options, Reason, Refusal, Refuser, first_order, first_term};
use crate::derivation::DerivationLine;
use crate::exact::polynomial::Monomial;
use crate::exact::{POLYNOMIALS, Polynomial, Rational};
use crate::expr::Expr;
use crate::interrupt::Supervision;
use crate::oscillator::{Oscillator, OscillatorError, Parts, PerturbedForce, SmallParameter, Term};
use crate::series::taylor::TaylorError;
use crate::solution::note::{ExactBy, Truncation};
use crate::solution::{AmplitudeConvention, Definition, Law, LimitCycle, Method, Note, Solution};
use crate::symbol::letters::FIRST_HARMONIC;
use crate::symbol::{Symbol, fresh};

/// Derives frequency and motion as power series in the small parameter.
///
/// # Errors
/// Damping, forcing, or a force that cannot be expanded, each by name.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    let parts = oscillator.parts()?;
    if !parts.forcing.is_zero() {
        return Err(Reason::Forcing
            .refused_by(Refuser::Expansion)
            .about(first_term(&parts.forcing)));
    }
    let mut perturbation = match perturbation(oscillator, &parts, options) {
        Err(
            refusal @ Refusal {
                reason: Reason::Oscillator(OscillatorError::NotPolynomial(_)), ..
            },
        ) => {
            return in_a_parameter(oscillator, &parts, options)?.ok_or(refusal);
        }
        other => other?,
    };
    perturbation.force.write_with_frequency(&oscillator.names());
    let force = &perturbation.force;
    let LinearPart { frequency: linear_frequency, root, mut definitions, taken } =
        LinearPart::new(force, oscillator);

    let units = FrequencyUnits::new(force, linear_frequency.clone());
    let excited = self_excitation(&perturbation, &units, &parts, options.cycle, &taken)?;
    let cycle = excited.as_ref().map(SelfExcitation::cycle);
    let convention = options.amplitude.unwrap_or(match cycle {
        Some(_) => AmplitudeConvention::FirstHarmonic,
        None => AmplitudeConvention::Initial,
    });
    let of_cycle = cycle.and_then(|cycle| cycle.definition.clone());
    definitions.extend(of_cycle.clone());
    definitions.extend(perturbation.bookkeeping.clone());
    let extent = match options.frequency_alone {
        true => ExpansionScope::Frequency,
        false => ExpansionScope::Motion,
    };
    let names = (taken.as_slice(), extent);
    let supervision = options.supervision;
    let series = expanded(
        &perturbation,
        excited.as_ref(),
        &units,
        &parts,
        convention,
        (names, supervision),
    )?;
    let asked = perturbation.order;
    perturbation.order = asked.min(series.highest);

    let in_numbers = |polynomial: Polynomial| match (&root, force.linear.as_number()) {
        (Some(root), Some(square)) => with_square(&polynomial, root.symbol, &square),
        _ => polynomial,
    };
    let unit = unit_of(cycle, convention);
    let displacement = series
        .displacement
        .map(POLYNOMIALS, |coefficient, _| in_numbers(reduced(cycle, coefficient.product(&unit))));
    // In powers of the amplitude, the small parameter is the symbol that stands for it.
    let small = perturbation.marker.map_or(convention.symbol(), |_| perturbation.small);
    let amplitude = match extent {
        ExpansionScope::Motion => amplitude_of(&displacement, convention),
        // Without the motion the amplitude is known to leading order only.
        ExpansionScope::Frequency => in_numbers(unit.clone()),
    };
    let limit_cycle =
        excited.as_ref().map(|excited| excited.limit_cycle(&perturbation, small, amplitude));
    let mut validity = vec![match is_free_and_linear(oscillator)? {
        true => Note::Exact(ExactBy::Linear),
        false => perturbation.cut(small),
    }];
    if perturbation.order < asked {
        validity.push(Note::Stopped { asked });
    }
    if let (Some(excited), Some(limit_cycle)) = (&excited, &limit_cycle) {
        let own = &limit_cycle.cycles[excited.number - 1];
        validity.push(Note::Stability(own.clone()));
        validity.extend(excited.cycle().remark.clone());
    }
    validity.extend(root.iter().cloned().chain(of_cycle).map(Note::Positive));
    let squared = series.frequency_squared.product(&linear_frequency.product(&linear_frequency));
    Ok(Solution {
        equation: oscillator.equation(),
        method: Method::LindstedtPoincare,
        order: perturbation.order,
        degrees: None,
        small_parameter: small,
        amplitude: convention,
        parameters: oscillator.parameters.clone(),
        definitions,
        equilibrium: Expr::zero(),
        law: Law::Series {
            squared: in_numbers(squared),
            frequency: Some(in_numbers(series.frequency.product(&linear_frequency))),
        },
        displacement,
        limit_cycle,
        modulation: None,
        response: None,
        numerical: false,
        closed_motion: None,
        convergence: None,
        validity,
        steps: series.steps,
        derivation: vec![DerivationLine::equation(
            Expr::from(oscillator.linear_frequency_name(&force.linear)).integer_power(2)?,
            &force.linear,
        )],
    })
}

/// The linear part of a force, and the names that it brings with it.
pub(super) struct LinearPart {
    /// The linear frequency: `omega0`, or its value if it needs no name.
    pub(super) frequency: Polynomial,
    /// The definition of `omega0`, if it is not a polynomial.
    pub(super) root: Option<Definition>,
    /// The definition of `omega0`, and the constants of the other terms.
    pub(super) definitions: Vec<Definition>,
    /// The names of the equation and of the definitions.
    pub(super) taken: Vec<Symbol>,
}

impl LinearPart {
    pub(super) fn new(force: &PerturbedForce, oscillator: &Oscillator) -> Self {
        let mut taken = oscillator.names();
        let (frequency, root) = force.linear_frequency(&taken);
        let constants = constants_beside(force, &frequency);
        let definitions: Vec<Definition> = root.clone().into_iter().chain(constants).collect();
        taken.extend(definitions.iter().map(|definition| definition.symbol));
        Self { frequency, root, definitions, taken }
    }
}

/// The definitions of the force that a formula about it needs: constants of the linear force alone
/// are written out in that of the linear frequency.
fn constants_beside(force: &PerturbedForce, linear_frequency: &Polynomial) -> Vec<Definition> {
    let coefficients = force.terms.iter().map(|term| &term.coefficient);
    let used: BTreeSet<Symbol> =
        coefficients.chain([linear_frequency]).flat_map(Polynomial::symbols).collect();
    let constants = force.definitions.iter();
    constants.filter(|entry| used.contains(&entry.symbol)).cloned().collect()
}

/// The limit cycles of a self-excited equation.
struct SelfExcitation {
    equation: AmplitudeEquation,
    cycles: Vec<Cycle>,
    /// Number of the cycle asked for, counted from one.
    number: usize,
}

impl SelfExcitation {
    fn cycle(&self) -> &Cycle {
        &self.cycles[self.number - 1]
    }

    /// The limit cycle as the answer states it; `small` is the small parameter of the answer.
    fn limit_cycle(
        &self,
        perturbation: &Perturbation,
        small: Symbol,
        amplitude: Polynomial,
    ) -> LimitCycle {
        let marker = perturbation.marker.unwrap_or(small);
        LimitCycle {
            amplitude,
            number: self.number,
            cycles: self.cycles.iter().map(|cycle| cycle.to_leading(marker, small)).collect(),
            small_with: perturbation.small_with.clone(),
        }
    }
}

/// The limit cycles and the one that is asked for, where the equation determines its amplitude.
fn self_excitation(
    perturbation: &Perturbation,
    units: &FrequencyUnits,
    parts: &Parts,
    asked: Option<u32>,
    taken: &[Symbol],
) -> Result<Option<SelfExcitation>, Refusal> {
    let Some(equation) = AmplitudeEquation::new(&perturbation.force, units) else {
        return match asked {
            Some(asked) => Err(Reason::NoSuchCycle(asked, 0).into()),
            None => Ok(None),
        };
    };
    let without = |reason| {
        let equation = equation.in_square(fresh("z", taken));
        Refusal::from(Reason::LimitCycle { equation, reason })
    };
    let marker = perturbation.marker.unwrap_or(perturbation.small);
    let cycles = equation.cycles(marker, &units.frequency, taken).map_err(without)?;
    if perturbation.marker.is_none() {
        return Err(amplitude_not_free(parts));
    }
    let number = chosen(&cycles, asked, || match equation.is_single_term() {
        true => damped(parts),
        false => Reason::NoLimitCycle(equation.in_square(fresh("z", taken))).into(),
    })?;
    if cycles[number - 1].attracts_where.is_none() {
        return Err(without("a multiple root: no expansion in powers begins there"));
    }
    Ok(Some(SelfExcitation { equation, cycles, number }))
}

/// The unit of the motion: the amplitude of the cycle to leading order, or the amplitude symbol of
/// a free motion.
fn unit_of(cycle: Option<&Cycle>, convention: AmplitudeConvention) -> Polynomial {
    cycle.map_or_else(|| Polynomial::symbol(convention.symbol()), |cycle| cycle.unit.clone())
}

/// A polynomial with the powers of the amplitude of the cycle reduced by the equation that it
/// solves.
fn reduced(cycle: Option<&Cycle>, polynomial: Polynomial) -> Polynomial {
    match cycle {
        Some(cycle) => cycle.reduced(&polynomial),
        None => polynomial,
    }
}

/// Frequency and motion in units of the linear frequency and of the [amplitude](unit_of).
fn expanded(
    perturbation: &Perturbation,
    excited: Option<&SelfExcitation>,
    units: &FrequencyUnits,
    parts: &Parts,
    convention: AmplitudeConvention,
    (names, supervision): ((&[Symbol], ExpansionScope), Supervision),
) -> Result<ExactSeries, Refusal> {
    let cycle = excited.map(SelfExcitation::cycle);
    let scheme = Scheme {
        normalisation: convention,
        amplitude: match cycle {
            Some(_) => AmplitudeKind::Determined,
            None => AmplitudeKind::Free,
        },
        detuning: Detuning::Acceleration,
    };
    let terms = scaled_terms(&perturbation.force.terms, &unit_of(cycle, convention), units);
    let terms: Vec<Term> = terms
        .into_iter()
        .map(|term| Term { coefficient: reduced(cycle, term.coefficient), ..term })
        .collect();
    let delta = perturbation.delta(convention);
    let inverse_slope = cycle.and_then(|cycle| cycle.inverse_slope.as_ref());
    let order = perturbation.order;
    let series =
        expand_exactly(&terms, order, &scheme, Some(delta), inverse_slope, names, supervision);
    let mut series = series.map_err(|error| match error {
        SecularError::Growth { .. } | SecularError::Degenerate { .. }
            if !parts.damping.is_zero() =>
        {
            damping_or_excitation(parts)
        }
        error => error.into(),
    })?;
    if let Some(excited) = excited {
        let is_parameter = delta == perturbation.small;
        // The bookkeeping parameter is one if it is not a parameter of the answer.
        let one = Polynomial::constant(One::one());
        let unmarked = |polynomial: &Polynomial| {
            let unmarked = if is_parameter { None } else { polynomial.substitute(delta, &one) };
            reduced(cycle, unmarked.unwrap_or_else(|| polynomial.clone()))
        };
        series.change_coefficients(&unmarked);
        if let Some(start) = series.steps.first_mut() {
            let marked = is_parameter.then_some(delta);
            let condition = excited.equation.condition(
                excited.cycle(),
                fresh(&format!("{FIRST_HARMONIC}0"), names.0),
                marked,
            );
            start.amplitude = Some(condition);
        }
    }
    Ok(series)
}

/// A polynomial in a root of a number, its even powers written as the number: `sqrt(2)^2` as 2,
/// `1/sqrt(2)^3` as half of `1/sqrt(2)`. Terms that cancel between the powers then cancel exactly.
pub(super) fn with_square(polynomial: &Polynomial, root: Symbol, square: &Rational) -> Polynomial {
    let mut written = Polynomial::zero();
    for (monomial, number) in polynomial.terms() {
        let pairs = monomial.exponent(root) / 2;
        let rest = Monomial::power_of(root, monomial.exponent(root) % 2);
        written.add_term(monomial.without(root).product(&rest), number * square.pow(pairs));
    }
    written
}

/// The force to be expanded, and the small parameters.
struct Perturbation {
    force: PerturbedForce,
    /// The parameter that marks the orders; `None` if it is the amplitude.
    marker: Option<Symbol>,
    /// The small parameter of the answer.
    small: Symbol,
    /// Parameters that are small together with it.
    small_with: Vec<Symbol>,
    order: u32,
    /// The value of a small parameter that the equation does not have.
    bookkeeping: Option<Definition>,
}

impl Perturbation {
    /// The expansion parameter: the symbol of the amplitude if there is no other.
    fn delta(&self, convention: AmplitudeConvention) -> Symbol {
        self.marker.unwrap_or(convention.symbol())
    }

    /// The note of the truncation, in the small parameter of the answer.
    fn cut(&self, small: Symbol) -> Note {
        let together = self.small_with.iter().copied();
        Note::Cut(Truncation::Truncated {
            small: std::iter::once(small).chain(together).collect(),
            order: self.order,
            marks: self.bookkeeping.as_ref().map(|definition| definition.meaning.clone()),
        })
    }
}

/// The first order in a parameter, of a force that is not a polynomial; `None` if the amplitude is
/// the small parameter.
fn in_a_parameter(
    oscillator: &Oscillator,
    parts: &Parts,
    options: &Options,
) -> Result<Option<Solution>, Refusal> {
    match oscillator.small_parameter(options.small.as_deref()) {
        // Such a force has no higher order to default to.
        Ok(SmallParameter::Parameter(small)) => {
            first_order::solve(oscillator, parts, options, small, options.order.unwrap_or(1))
        }
        _ => Ok(None),
    }
}

/// The force in powers of the small parameter; a self-excited equation without one is expanded in a
/// bookkeeping parameter of all terms but the linear one.
fn perturbation(
    oscillator: &Oscillator,
    parts: &Parts,
    options: &Options,
) -> Result<Perturbation, Refusal> {
    let small = oscillator.small_parameter(options.small.as_deref())?;
    let default = if small == SmallParameter::Amplitude { 4 } else { 2 };
    let order = options.order.unwrap_or(default);
    let expanded = oscillator.expand(small, order);
    if let Ok(force) = &expanded {
        within_reach(force, parts, order)?;
    }
    let excited = match &expanded {
        Ok(force) => small == SmallParameter::Amplitude && has_drift(force),
        Err(error) => matches!(error, OscillatorError::NotSmall { .. }),
    };
    let in_amplitude = options.small.is_some() && small == SmallParameter::Amplitude;
    if excited && !parts.damping.is_zero() && !in_amplitude {
        let order = options.order.unwrap_or(2);
        let joint = expand_jointly(oscillator, parts, small, order);
        if let Some(joint) = &joint {
            within_reach(&joint.force, parts, order)?;
        }
        if let Some(joint) = joint.filter(|joint| may_balance(&joint.force)) {
            let bookkeeping = joint
                .value
                .map(|value| Definition { symbol: joint.delta, meaning: Expr::number(value) });
            let mut parameters = joint.parameters.into_iter();
            let first = match bookkeeping {
                None => parameters.next(),
                Some(_) => None,
            };
            return Ok(Perturbation {
                force: joint.force,
                marker: Some(joint.delta),
                small: first.unwrap_or(joint.delta),
                small_with: parameters.collect(),
                order,
                bookkeeping,
            });
        }
    }
    let force = match expanded {
        // Damping and excitation are named as the reason of the refusal.
        Err(OscillatorError::NotSmall { .. })
            if small == SmallParameter::Amplitude && !parts.damping.is_zero() =>
        {
            return Err(damping_or_excitation(parts));
        }
        Err(OscillatorError::NotSmall { term, .. })
            if parts.damping.terms().contains(term.expression()) =>
        {
            return Err(Refusal::damping(term.expression(), Refuser::Expansion));
        }
        // |x'| x', a dry friction and their like damp whether or not they have a series.
        Err(
            OscillatorError::NotPolynomial(_)
            | OscillatorError::Taylor(TaylorError::NotAnalytic { .. }),
        ) if !parts.damping.is_zero()
            && (small == SmallParameter::Amplitude || parts.damping.terms().len() == 1) =>
        {
            return Err(damping_or_excitation(parts));
        }
        expanded => expanded?,
    };
    let marker = match small {
        SmallParameter::Parameter(name) => Some(name),
        SmallParameter::Amplitude => None,
    };
    Ok(Perturbation {
        force,
        marker,
        small: marker.unwrap_or(AmplitudeConvention::Initial.symbol()),
        small_with: vec![],
        order,
        bookkeeping: None,
    })
}

/// An error if powers are so high that even the first order of the amplitude would take too long.
fn within_reach(force: &PerturbedForce, parts: &Parts, order: u32) -> Result<(), SecularError> {
    let terms = force.terms.iter().map(|term| (term.order, term.position + term.velocity));
    // The last amplitude of a limit cycle follows from one order more.
    bounded(terms, order as usize + usize::from(!parts.damping.is_zero()))
}

/// Whether the amplitude changes, at whatever order of an expansion in it.
fn has_drift(force: &PerturbedForce) -> bool {
    let mut together = force.clone();
    for term in &mut together.terms {
        term.order = 1;
    }
    drift(&together).is_some()
}

/// Whether the energy that some terms feed may balance the energy that others dissipate at some
/// amplitude.
pub(super) fn may_balance(force: &PerturbedForce) -> bool {
    drift(force).is_some_and(|equation| !equation.is_single_term())
}

fn drift(force: &PerturbedForce) -> Option<AmplitudeEquation> {
    AmplitudeEquation::new(force, &FrequencyUnits::new(force, force.linear_frequency(&[]).0))
}

fn damped(parts: &Parts) -> Refusal {
    Refusal::damping(first_term(&parts.damping), Refuser::Expansion)
}

/// The refusal of terms odd in the velocity. A single one damps, or excites, at all amplitudes;
/// several may feed energy for some motions and dissipate it for others.
fn damping_or_excitation(parts: &Parts) -> Refusal {
    match parts.damping.terms() {
        [_] => damped(parts),
        _ => amplitude_not_free(parts),
    }
}

fn amplitude_not_free(parts: &Parts) -> Refusal {
    Refusal::from(Reason::AmplitudeNotFree).about(first_term(&parts.damping))
}

/// The terms in `y = x / unit` and the time of the linear frequency: `C_j` in the head of this
/// file.
fn scaled_terms(terms: &[Term], unit: &Polynomial, units: &FrequencyUnits) -> Vec<Term> {
    let scale = |term: &Term| {
        let exponent = (term.position + term.velocity) as i32 - 1;
        let unit = unit.power(exponent).unwrap_or_else(Polynomial::zero);
        let frequency = units.power_of_frequency(term.velocity as i32 - 2);
        Term { coefficient: term.coefficient.product(&unit).product(&frequency), ..term.clone() }
    };
    terms.iter().map(scale).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quotient whose singularity is removable is its power series.
    #[test]
    fn removable_singularities_are_their_series() {
        for (quotient, series) in [
            ("(1 - cos(x))/x", "x/2 - x^3/24 + x^5/720"),
            ("(exp(x) - 1)/x - 1", "x/2 + x^2/6 + x^3/24 + x^4/120 + x^5/720"),
            ("x^2/tan(x)", "x - x^3/3 - x^5/45"),
        ] {
            let laws = [quotient, series].map(|force| {
                let oscillator = Oscillator::parse(&format!("x'' + {force} = 0")).unwrap();
                let solution = crate::method::solve(&oscillator, &Options::default()).unwrap();
                (solution.law.frequency_squared().cloned(), solution.displacement)
            });
            assert_eq!(laws[0], laws[1], "{quotient}");
        }
        let mixed = Oscillator::parse("x'' + x + x'^2/x = 0").unwrap();
        let refusal = crate::method::solve(&mixed, &Options::default()).unwrap_err();
        assert!(refusal.to_string().contains("`x'^2/x`"), "{refusal}");
    }

    #[test]
    fn what_is_odd_in_the_velocity_damps_with_or_without_a_series() {
        for (equation, term) in [
            ("x'' + x + abs(x')*x' = 0", "x'*abs(x')"),
            ("x'' + x + x^3 + mu*sgn(x') = 0", "mu*sgn(x')"),
            ("x'' + x + eps*abs(x')*x' = 0", "eps*x'*abs(x')"),
            ("x'' + x + x'*abs(x) = 0", "x'*abs(x)"),
            ("x'' + x + c*x'^(1/3) = 0", "c*x'^(1/3)"),
        ] {
            let refusal =
                solve(&Oscillator::parse(equation).unwrap(), &Options::default()).unwrap_err();
            let term = crate::expr::parse_expression(term).unwrap();
            let expected = Refusal::damping(&term, Refuser::Expansion);
            assert_eq!(refusal, expected, "{equation}");
        }
    }
}

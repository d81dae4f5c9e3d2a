//! The method of multiple scales: a slow time for each order, amplitude and phase that change on them.
//!
//! Reference: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, sections 2.3.3 (free), 3.1 to 3.4 (damped and
//! self-excited), 4.1 and 5.7 (driven).
//!
//! ```text
//! x = a cos(theta) + sum eps^k x_k(a, theta)
//! a' = sum eps^k f_k(a),   theta' = omega0 + sum eps^k g_k(a),   f_k + i a g_k = 2 e^(-i beta) D_k B,  B = (a/2) e^(i beta)
//! ```
//!
//! What the slow derivatives `D_k B` are is for [`slow_times`]. The motion leaves out homogeneous solutions, so `a` is the
//! amplitude of the first harmonic to every order. A free conservative motion keeps its amplitude, and `theta'` is its
//! frequency; a self-excited one ends where `f = 0`, on a limit cycle.
//!
//! Parameters that have to vanish together, as in `x'' + 2*zeta*x' + x + eps*x^3 = 0`, count as equally small. In powers of the
//! amplitude a linear damping counts as its square, so that it appears beside the first effect of a cubic force.
//!
//! ```
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::MultipleScales), order: Some(2), ..Options::default() };
//! let law = solve(&duffing, &options)?.law;
//! assert_eq!(law.frequency().unwrap().to_string(), "1 + 3*eps*a^2/8 - 15*eps^2*a^4/256");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod driven;
mod scaling;
mod slow_times;

pub use self::driven::with_resonance_at;

use num_traits::{One, Zero};

use self::scaling::{Scaling, scaling};
use self::slow_times::{Amplitude, Complex, DrivenTerm, Expansion, Scaled, Wave};
use super::limit_cycle::{AmplitudeEquation, Cycle, Units, chosen};
use super::lindstedt_poincare::{LinearPart, with_square};
use super::{Options, Refusal, Unsuited};
use crate::derivation::{Formula, Line};
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{POLYNOMIALS, Polynomial, Rational};
use crate::expr::Expr;
use crate::oscillator::Oscillator;
use crate::series::FourierSeries;
use crate::solution::modulation::Release;
use crate::solution::{AmplitudeConvention, Law, LimitCycle, Method, Modulation, Note, Response, Solution};
use crate::symbol::{Symbol, fresh, fresh_stem};

/// The highest order in a parameter.
const HIGHEST_IN_PARAMETER: u32 = 3;

/// The highest order in the amplitude, of which an odd force has every other one.
const HIGHEST_IN_AMPLITUDE: u32 = 6;

/// Derives the slow equations and the motion as power series in the small parameter.
///
/// # Errors
/// A drive, or a force that cannot be expanded, each by name; an order above those that there are.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    let parts = oscillator.parts()?;
    if options.amplitude == Some(AmplitudeConvention::Initial) {
        return Err(Unsuited::ConventionOfFirstHarmonic.to(Method::MultipleScales));
    }
    if !parts.forcing.is_zero() {
        return driven::solve(oscillator, &parts, options);
    }
    if options.resonance.is_some() {
        let choice = super::table::Choice::Resonance;
        return Err(Unsuited::NoSuchChoice { choice }.to(Method::MultipleScales));
    }
    let highest = [HIGHEST_IN_PARAMETER, HIGHEST_IN_AMPLITUDE];
    let scaling = scaling(oscillator, &parts, options, [2, 4], highest)?;
    let force = &scaling.force;
    let LinearPart {
        frequency: linear_frequency,
        root,
        mut definitions,
        taken,
    } = LinearPart::of(force, oscillator);

    let units = Units::new(force, linear_frequency.clone());
    let cycles = cycles(&scaling, &units, options, &taken)?;
    let names = Names::new(&taken, oscillator.coordinate, scaling.marker);
    // The last correction of the amplitude of a limit cycle follows from one order more.
    let order = scaling.order as usize;
    let scaled = Scaled {
        terms: force.terms.iter().map(undriven).collect(),
        linear_frequency: linear_frequency.clone(),
        own: 1,
        detuning: None,
        forced: None,
        order: order + usize::from(cycles.is_some()),
    };
    let expansion = scaled.expand(names.complex);
    let slow = SlowEquations::new(&expansion, &linear_frequency, &names);

    let in_numbers = |polynomial: &Polynomial| match (&root, force.linear.as_number()) {
        (Some(root), Some(square)) => with_square(polynomial, root.symbol, &square),
        _ => polynomial.clone(),
    };
    let unmarked = |polynomial: &Polynomial| in_numbers(&scaling.unmarked(polynomial, names.marker));
    let amplitude = AmplitudeConvention::FirstHarmonic.symbol();
    let cut = |polynomial: &Polynomial| polynomial.truncated(names.marker, order as i32);
    let motion: Vec<FourierSeries<_>> = (0..=order)
        .map(|k| motion_of(&expansion.displacement[k], k, &names))
        .collect();
    let displacement = motion
        .iter()
        .fold(FourierSeries::zero(POLYNOMIALS), |sum, term| sum.sum(term));
    let amplitude_rate = unmarked(&cut(&slow.amplitude));
    let phase_rate = unmarked(&cut(&slow.phase));
    let rates = [&amplitude_rate, &phase_rate].map(Expr::from);
    let derivation = derivation(&expansion, &scaling, &names, &linear_frequency, &rates, None)?;

    let mut validity = vec![scaling.cut_note()];
    let mut limit_cycle = None;
    let (law, displacement) = match &cycles {
        None => (phase_rate.clone(), displacement),
        Some(found) => {
            let cycle = &found.cycles[found.number - 1];
            let at = slow
                .at_cycle(cycle, &linear_frequency, order, &names)
                .ok_or_else(|| Refusal::LimitCycle {
                    equation: found.equation.in_square(fresh("z", &taken)),
                    reason: "which divides by a sum of symbols",
                })?;
            let put = |polynomial: &Polynomial| {
                let value = polynomial.substitute(amplitude, &at);
                cycle.reduced(&cut(&value.unwrap_or_else(Polynomial::zero)))
            };
            definitions.extend(cycle.definition.clone());
            let leading = found.cycles.iter();
            limit_cycle = Some(LimitCycle {
                amplitude: unmarked(&cycle.reduced(&cut(&at))),
                number: found.number,
                cycles: leading
                    .map(|cycle| cycle.to_leading(names.marker, scaling.small))
                    .collect(),
                small_with: scaling.small_with.clone(),
            });
            let own = limit_cycle
                .iter()
                .filter_map(|cycle| cycle.cycles.get(cycle.number - 1));
            validity.extend(own.cloned().map(Note::Stability));
            validity.extend(cycle.remark.clone());
            validity.extend(cycle.definition.clone().map(Note::Positive));
            let displacement = displacement.map(POLYNOMIALS, |coefficient, _| put(coefficient));
            (unmarked(&put(&slow.phase)), displacement)
        }
    };
    definitions.extend(scaling.bookkeeping.clone());
    validity.extend(root.clone().map(Note::Positive));
    // Where the amplitude changes the motion has a start.
    let changes = limit_cycle.is_none() && !amplitude_rate.is_zero();
    let modulation = Modulation {
        amplitude,
        phase: names.phase,
        amplitude_rate: Expr::from(&amplitude_rate),
        phase_rate: Expr::from(&phase_rate),
        small_with: scaling.small_with.clone(),
        resonance: None,
        release: changes.then(Release::at_start),
        transient: None,
        steady: limit_cycle.iter().flat_map(|cycle| cycle.cycles.clone()).collect(),
    };
    Ok(Solution {
        equation: oscillator.equation(),
        method: Method::MultipleScales,
        order: scaling.order,
        degrees: None,
        small_parameter: scaling.small,
        amplitude: AmplitudeConvention::FirstHarmonic,
        parameters: oscillator.parameters.clone(),
        definitions,
        equilibrium: Expr::zero(),
        law: Law::Frequency(law),
        displacement: displacement.map(POLYNOMIALS, |coefficient, _| unmarked(coefficient)),
        limit_cycle,
        modulation: Some(modulation),
        response: None,
        numerical: false,
        validity,
        steps: vec![],
        derivation,
    })
}

/// A term of a force that does not know the time.
fn undriven(term: &crate::oscillator::Term) -> DrivenTerm {
    DrivenTerm {
        order: term.order,
        position: term.position,
        velocity: term.velocity,
        coefficient: term.coefficient.clone(),
        drive: None,
    }
}

/// What the derivation introduces.
struct Names {
    complex: Amplitude,
    /// Marks the orders: the small parameter, or a symbol that is one.
    marker: Symbol,
    /// The slow phase.
    phase: Symbol,
    amplitude: Symbol,
    /// The imaginary unit.
    unit: Symbol,
    /// What the orders of the motion are called before their numbers, and the rates of `B` on the times.
    orders: [String; 2],
}

impl Names {
    fn new(taken: &[Symbol], coordinate: Symbol, marker: Option<Symbol>) -> Self {
        let own = fresh("B", taken);
        Self {
            unit: fresh("i", taken),
            orders: [coordinate, own].map(|name| fresh_stem(name.name(), taken)),
            complex: Amplitude {
                own,
                conjugate: fresh("Bc", taken),
            },
            marker: marker.unwrap_or_else(|| fresh("delta", taken)),
            phase: fresh("psi", taken),
            amplitude: AmplitudeConvention::FirstHarmonic.symbol(),
        }
    }

    fn mark(&self, order: usize) -> Monomial {
        Monomial::power_of(self.marker, i32::try_from(order).unwrap_or(i32::MAX))
    }

    /// A polynomial with `B` and its conjugate as `a/2`.
    fn polar(&self, polynomial: &Polynomial) -> Polynomial {
        let mut result = Polynomial::zero();
        for (monomial, number) in polynomial.terms() {
            let exponent = monomial.exponent(self.complex.own) + monomial.exponent(self.complex.conjugate);
            let rest = monomial.without(self.complex.own).without(self.complex.conjugate);
            let halves = Rational::new(One::one(), 2.into()).pow(exponent);
            result.add_term(
                rest.product(&Monomial::power_of(self.amplitude, exponent)),
                number * halves,
            );
        }
        result
    }
}

/// `a'` and `theta'` in powers of the marker.
struct SlowEquations {
    amplitude: Polynomial,
    phase: Polynomial,
}

impl SlowEquations {
    fn new(expansion: &Expansion, linear_frequency: &Polynomial, names: &Names) -> Self {
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

    /// The amplitude at which `a' = 0`, in powers of the marker; `None` where it needs a quotient that is no polynomial.
    fn at_cycle(
        &self,
        cycle: &Cycle,
        linear_frequency: &Polynomial,
        order: usize,
        names: &Names,
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

/// The limit cycles of a self-excited equation, and which of them is asked for.
struct Cycles {
    equation: AmplitudeEquation,
    cycles: Vec<Cycle>,
    number: usize,
}

fn cycles(scaling: &Scaling, units: &Units, options: &Options, taken: &[Symbol]) -> Result<Option<Cycles>, Refusal> {
    let without = match options.cycle {
        Some(asked) => Err(Refusal::NoSuchCycle { asked, count: 0 }),
        None => Ok(None),
    };
    let (Some(equation), Some(marker)) = (AmplitudeEquation::new(&scaling.force, units), scaling.marker) else {
        return without;
    };
    let refused = |reason| Refusal::LimitCycle {
        equation: equation.in_square(fresh("z", taken)),
        reason,
    };
    let cycles = equation.cycles(marker, &units.frequency, taken).map_err(refused)?;
    if cycles.is_empty() {
        return without;
    }
    let none = || Refusal::NoSuchCycle { asked: 0, count: 0 };
    let number = chosen(&cycles, options.cycle, none)?;
    if cycles[number - 1].attracts_where.is_none() {
        return Err(refused("a multiple root: no expansion in powers begins there"));
    }
    Ok(Some(Cycles {
        equation,
        cycles,
        number,
    }))
}

/// What an order adds to the motion, in `theta`, with `B = a/2`.
fn motion_of(wave: &Wave, order: usize, names: &Names) -> FourierSeries<crate::exact::Polynomials> {
    let length = wave.keys().copied().max().map_or(0, |m| m.max(0) as usize + 1);
    let (mut cosine, mut sine) = (vec![Polynomial::zero(); length], vec![Polynomial::zero(); length]);
    for (m, value) in wave.iter().filter(|entry| *entry.0 >= 0) {
        let m = *m as usize;
        let part = |part: &Polynomial, factor: i64| {
            let factor = if m == 0 { factor / 2 } else { factor };
            let scaled = names.polar(part).product(&Polynomial::constant(ratio(factor, 1)));
            scaled.times_monomial(&names.mark(order))
        };
        cosine[m] = part(&value.real, 2);
        sine[m] = part(&value.imaginary, -2);
    }
    FourierSeries::from_parts(POLYNOMIALS, cosine, sine)
}

/// How the answer came about; `response` is what follows for a driven motion.
fn derivation(
    expansion: &Expansion,
    scaling: &Scaling,
    names: &Names,
    linear_frequency: &Polynomial,
    rates: &[Expr; 2],
    response: Option<&Response>,
) -> Result<Vec<Line>, Refusal> {
    let (own, conjugate, a) = (names.complex.own, names.complex.conjugate, names.amplitude);
    let i = Expr::from(names.unit);
    let [orders, times] = &names.orders;
    let complex = |value: &Complex| &Expr::from(&value.real) + &(&i * &Expr::from(&value.imaginary));
    let small = match scaling.marker {
        Some(marker) => marker.to_string(),
        None => a.to_string(),
    };
    let wave = format!("exp({i}*theta)");
    let turns = match response {
        None => format!("theta turns at the rate {}", Expr::from(linear_frequency)),
        Some(_) => "theta turns in step with the drive; what that forces far from resonance is added".to_owned(),
    };
    let mut lines = vec![
        Line::words(format!(
            "the motion is {orders}0 + {orders}1 + {orders}2 + ..., each order with its power of {small} and a slow time of its own"
        )),
        Line::words(format!(
            "{orders}0 = {own}*{wave} + {conjugate}*exp(-{i}*theta), {conjugate} the conjugate of {own}; {turns}"
        )),
        Line::words(format!(
            "{times}1, {times}2, ... are the rates of {own} on the slow times"
        )),
    ];
    for k in 1..=scaling.order as usize {
        let (rate, resonant) = (&expansion.rates[k], &expansion.resonant[k]);
        if resonant.is_zero() && expansion.displacement[k].is_empty() {
            continue;
        }
        let left = Expr::symbol(&format!("{times}{k}"));
        let rest = Expr::from(&linear_frequency.product(&Polynomial::constant(ratio(2, 1))));
        let secular = &complex(resonant) - &(&(&i * &rest) * &left);
        lines.push(
            Line::equal([secular.expand()?.into(), Expr::zero().into()])
                .because(format!("order {k}, no {wave} on the right")),
        );
        lines.push(Line::equation(left, complex(rate).expand()?).because("fixes"));
        if response.is_none() {
            let unmarked = |polynomial: &Polynomial| scaling.unmarked(polynomial, names.marker);
            let motion = motion_of(&expansion.displacement[k], k, names);
            let motion = motion.map(POLYNOMIALS, |coefficient, _| unmarked(coefficient));
            lines.push(
                Line::equation(Symbol::new(&format!("{orders}{k}")), motion)
                    .because(format!("the motion, with {own} = {a}/2 in theta")),
            );
        }
    }
    let [amplitude_rate, phase_rate] = rates;
    let phase = names.phase;
    let polar = match response {
        None => format!("{own} is {a}/2 turned by the phase {phase} without theta"),
        Some(_) => format!("{own} is {a}/2 turned back by the phase {phase}"),
    };
    lines.push(Line::equation(a.derivative(), amplitude_rate).because(polar));
    lines.push(Line::equation(phase.derivative(), phase_rate));
    if let Some(relation) = response.and_then(|response| response.relation.as_ref()) {
        let zero = Formula::from(Expr::zero());
        let steady = "steady where both vanish; cos^2 + sin^2 = 1 eliminates the phase";
        lines.push(Line::equal([zero, Formula::from(Expr::from(relation))]).because(steady));
    }
    Ok(lines)
}

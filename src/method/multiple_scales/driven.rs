//! Driven motions: near a resonance the phase between drive and motion changes as slowly as the amplitude.
//!
//! Reference: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, sections 4.1 (primary, superharmonic and
//! subharmonic resonances of a cubic force), 4.2 (of a quadratic one) and 5.7 (parametric excitation).
//!
//! ```text
//! x'' + omega0^2 x + eps f(x, x') = (terms with one wave cos(Omega t) or sin(Omega t)),   q Omega = p omega0 + sigma
//! primary      p = q = 1:  the drive is small with eps      x = a cos(Omega t - psi) + ...
//! secondary    else:       the drive is not small           x = a cos((q Omega t - psi)/p) + 2 Lambda cos(Omega t) + ...,
//!                                                           Lambda = F/(2 (omega0^2 - Omega^2))
//! parametric   x cos(Omega t) is small with eps             x = a cos((q Omega t - psi)/p) + ...
//! a' = P + P_c cos(psi) + P_s sin(psi),   a psi'/p = Q + Q_c cos(psi) + Q_s sin(psi)
//! ```
//!
//! Where the motion is steady both vanish; the phase is eliminated by `cos^2 + sin^2 = 1`, which leaves the frequency-response
//! equation. To first order it is `P^2 + Q^2 = S^2`, with `S` what the drive does.

use std::collections::BTreeMap;

use num_traits::{Signed, Zero};

use super::answer::{Found, solution};
use super::derivation::derivation;
use super::names::Names;
use super::scaling::{Scaling, bounded, scaling};
use super::slow_times::{Complex, DrivenTerm, Expansion, Quadrature, Scaled};
use super::undriven;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{POLYNOMIALS, Polynomial, Rational};
use crate::expr::{Expr, Function, Node};
use crate::method::lindstedt_poincare::{LinearPart, with_square};
use crate::method::{Options, Refusal, Unsuited};
use crate::oscillator::{Oscillator, Parts};
use crate::series::FourierSeries;
use crate::solution::modulation::Resonance;
use crate::solution::response::{Branches, Plane, Response};
use crate::solution::{Definition, Law, Method, Modulation, Note, Solution};
use crate::symbol::{Symbol, fresh};
use crate::values::Values;

/// The highest order of a driven motion in a parameter; twice that in the amplitude.
const HIGHEST: u32 = 2;

/// The resonances that are looked for, Omega : omega0.
const RESONANCES: [(u32, u32); 5] = [(1, 1), (2, 1), (1, 2), (3, 1), (1, 3)];

/// A term of the force that a drive multiplies.
struct Driven {
    /// What stands before the wave.
    factor: Expr,
    quadrature: Quadrature,
    /// The whole term, for messages.
    term: Expr,
}

/// The slow equations of a driven motion, its frequency-response equation and what follows from it.
///
/// # Errors
/// A drive that is no single wave, a resonance that the equation does not have, or what stops an expansion.
pub(super) fn solve(oscillator: &Oscillator, parts: &Parts, options: &Options) -> Result<Solution, Refusal> {
    let refuse = |reason: Unsuited| reason.to(Method::MultipleScales);
    let (frequency, drives) = drives(parts)?;
    let mut free = oscillator.clone();
    free.force = (&oscillator.force - &parts.forcing).expand()?;
    let scaling = scaling(&free, &free.parts()?, options, [1, 2], [HIGHEST, 2 * HIGHEST])?;
    let scaling = scaling.spelt_out(&oscillator.names());
    let direct = |driven: &&Driven| {
        let own = [oscillator.coordinate, oscillator.velocity()];
        own.iter().all(|&name| !driven.factor.contains(name))
    };
    let forces: Vec<&Driven> = drives.iter().filter(direct).collect();
    let asked = options.resonance.map(|asked| vec![asked]);
    let candidates = asked.unwrap_or_else(|| match near(&scaling, &frequency) {
        Some(ratio) => by_distance(ratio),
        None if forces.is_empty() => vec![(2, 1), (1, 1)],
        None => vec![(1, 1)],
    });
    let first = candidates.first().copied().unwrap_or((1, 1));
    let reaches = |candidate: &(u32, u32)| resonates_at(*candidate, oscillator, &scaling, &frequency, &drives);
    let (p, q) = candidates.iter().copied().find(reaches).unwrap_or(first);
    if (p, q) == (1, 1) && grows(&scaling, &frequency, &drives) {
        let term = forces.first().map_or(&parts.forcing, |driven| &driven.term).clone();
        return Err(refuse(Unsuited::ResonanceWithoutDamping { term: term.into() }));
    }
    if let ((false, Some(second)), true) = ((p == q, forces.get(1)), forces.len() > 1) {
        let term = second.term.clone().into();
        return Err(refuse(Unsuited::SecondDrive { term }));
    }
    let question = Question::new(oscillator, &scaling, &frequency, (p, q))?;
    let expansion = question.expand(&drives, false)?;
    let slow = Slow::new(&expansion, &question);
    if !slow.is_resonant() {
        let others = RESONANCES.into_iter().filter(reaches).collect();
        let asked = (p, q);
        return Err(refuse(Unsuited::NoResonance { asked, others }));
    }
    let still = question.expand(&drives, true)?;
    answer(oscillator, &question, &expansion, &slow, &Slow::new(&still, &question))
}

/// The one driving frequency, and the terms that it drives.
///
/// # Errors
/// A term that is no wave of it, by name.
fn drives(parts: &Parts) -> Result<(Expr, Vec<Driven>), Refusal> {
    let refuse = |reason: Unsuited| reason.to(Method::MultipleScales);
    let t = Symbol::new("t");
    let mut frequency: Option<Expr> = None;
    let mut drives = Vec::new();
    for term in parts.forcing.terms() {
        let not_periodic = || {
            refuse(Unsuited::NoWave {
                term: term.clone().into(),
            })
        };
        let (number, factors) = term.factors();
        let (moving, still): (Vec<&Expr>, Vec<&Expr>) = factors.iter().partition(|factor| factor.contains(t));
        let [wave] = moving.as_slice() else {
            return Err(not_periodic());
        };
        let Node::Function(function, arguments) = wave.node() else {
            return Err(not_periodic());
        };
        let quadrature = match function {
            Function::Cos => Quadrature::Cosine,
            Function::Sin => Quadrature::Sine,
            _ => return Err(not_periodic()),
        };
        let rate = arguments.first().map(|argument| Expr::divide(argument, &Expr::from(t)));
        let mut rate = rate.ok_or_else(not_periodic)??.expand()?;
        if rate.contains(t) || rate.symbols().iter().any(|name| name.primes() > 0) {
            return Err(not_periodic());
        }
        let mut factor = Expr::product(std::iter::once(Expr::number(number)).chain(still.into_iter().cloned()));
        if rate.has_leading_minus() {
            rate = -&rate;
            if quadrature == Quadrature::Sine {
                factor = -&factor;
            }
        }
        match &frequency {
            Some(known) if *known != rate => {
                return Err(refuse(Unsuited::SecondDrive {
                    term: term.clone().into(),
                }));
            }
            _ => frequency = Some(rate),
        }
        drives.push(Driven {
            factor,
            quadrature,
            term: term.clone(),
        });
    }
    Ok((frequency.unwrap_or_else(Expr::one), drives))
}

/// The ratio of the driving frequency to the linear one, where both are numbers.
fn near(scaling: &Scaling, frequency: &Expr) -> Option<f64> {
    let driving = frequency.evaluate(&BTreeMap::new()).ok()?;
    let squared = scaling.force.linear_in_full().evaluate(&BTreeMap::new()).ok()?;
    Some(driving / squared.sqrt()).filter(|ratio| ratio.is_normal())
}

/// The resonances, the nearest to a ratio of the driving frequency to the linear one first.
fn by_distance(ratio: f64) -> Vec<(u32, u32)> {
    let distance = |(p, q): &(u32, u32)| (ratio * f64::from(*q) / f64::from(*p)).ln().abs();
    let mut sorted = RESONANCES.to_vec();
    sorted.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    sorted
}

/// The options with the resonance that is nearest to the frequencies at these values, of those that the equation has; as they
/// are where one is asked for, nothing drives the motion, or a value is missing.
///
/// ```
/// use lindstedt::{Method, Options, Oscillator, method::with_resonance_at};
///
/// let duffing = Oscillator::parse("x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)")?;
/// let at = "zeta = 1/100, eps = 1/10, F = 1, Omega = 1/3".parse()?;
/// assert_eq!(with_resonance_at(&duffing, &Options::default(), &at).resonance, Some((1, 3)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn with_resonance_at(oscillator: &Oscillator, options: &Options, at: &Values) -> Options {
    let found = || {
        let method = options.method.unwrap_or(Method::MultipleScales);
        if options.resonance.is_some() || method != Method::MultipleScales {
            return None;
        }
        let parts = oscillator.parts().ok().filter(|parts| !parts.forcing.is_zero())?;
        let (frequency, _) = drives(&parts).ok()?;
        let numbers = at.numbers();
        let stiffness = parts.restoring.differentiate(oscillator.coordinate).ok()?;
        let stiffness = stiffness.substitute(oscillator.coordinate, &Expr::zero()).ok()?;
        let ratio = frequency.evaluate(&numbers).ok()? / stiffness.evaluate(&numbers).ok()?.sqrt();
        let candidates = by_distance(Some(ratio).filter(|ratio| ratio.is_normal())?);
        candidates.into_iter().find(|candidate| {
            let asked = Options {
                resonance: Some(*candidate),
                method: Some(method),
                ..options.clone()
            };
            crate::method::solve(oscillator, &asked).is_ok()
        })
    };
    Options {
        resonance: options.resonance.or_else(found),
        ..options.clone()
    }
}

/// Whether a linear force without damping is driven at its own frequency.
fn grows(scaling: &Scaling, frequency: &Expr, drives: &[Driven]) -> bool {
    let linear = scaling.force.terms.is_empty();
    let squared = Expr::product([frequency.clone(), frequency.clone()]);
    let same = squared
        .expand()
        .is_ok_and(|squared| squared == scaling.force.linear_in_full());
    linear && same && !drives.is_empty()
}

/// A question to the expansion.
struct Question<'a> {
    oscillator: &'a Oscillator,
    scaling: &'a Scaling,
    frequency: &'a Expr,
    /// Omega : omega0.
    resonance: (u32, u32),
    linear_frequency: Polynomial,
    root: Option<Definition>,
    definitions: Vec<Definition>,
    names: Names,
    sigma: Symbol,
    lambda: Symbol,
    taken: Vec<Symbol>,
}

impl<'a> Question<'a> {
    fn new(
        oscillator: &'a Oscillator,
        scaling: &'a Scaling,
        frequency: &'a Expr,
        resonance: (u32, u32),
    ) -> Result<Self, Refusal> {
        let LinearPart {
            frequency: linear_frequency,
            root,
            definitions,
            taken,
        } = LinearPart::of(&scaling.force, oscillator);
        Ok(Self {
            oscillator,
            scaling,
            frequency,
            resonance,
            linear_frequency,
            root,
            definitions,
            names: Names::new(&taken, oscillator.coordinate, scaling.marker),
            sigma: fresh("sigma", &taken),
            lambda: fresh("Lambda", &taken),
            taken,
        })
    }

    /// The order at which detuning, damping and a small drive enter.
    fn small_order(&self) -> usize {
        if self.scaling.marker.is_some() { 1 } else { 2 }
    }

    /// A driven term in powers of what is small.
    fn scaled(&self, driven: &Driven) -> Result<DrivenTerm, Refusal> {
        let own = [self.oscillator.coordinate, self.oscillator.velocity()];
        let not_polynomial = || {
            Refusal::from(crate::oscillator::OscillatorError::NotPolynomial(
                driven.term.clone().into(),
            ))
        };
        let polynomial = driven.factor.to_polynomial(&mut |_| None)?.ok_or_else(not_polynomial)?;
        let (monomial, number) = polynomial.single_term().ok_or_else(not_polynomial)?;
        let exponent = |name| u32::try_from(monomial.exponent(name)).map_err(|_| not_polynomial());
        let (position, velocity) = (exponent(own[0])?, exponent(own[1])?);
        let mut rest = monomial.without(own[0]).without(own[1]);
        let small = || std::iter::once(self.scaling.small).chain(self.scaling.small_with.iter().copied());
        let written: i32 = small().map(|name| rest.exponent(name)).sum();
        if let Some(marker) = self.scaling.marker {
            rest = rest.without(marker);
        }
        // A drive without a small parameter counts as small as what it has to balance.
        let natural = if self.scaling.marker.is_none() {
            (position + velocity).saturating_sub(1) as usize
        } else {
            0
        };
        let order = match usize::try_from(written) {
            Ok(written) if written > 0 && self.scaling.marker.is_some() => written,
            _ => natural.max(self.small_order()),
        };
        Ok(DrivenTerm {
            order,
            position,
            velocity,
            coefficient: Polynomial::term(rest, number.clone()),
            drive: Some((self.resonance.0 as i32, driven.quadrature)),
        })
    }

    /// The expansion; `still` leaves damping out, and a small drive.
    fn expand(&self, drives: &[Driven], still: bool) -> Result<Expansion, Refusal> {
        let (p, q) = self.resonance;
        let mut terms: Vec<DrivenTerm> = self.scaling.force.terms.iter().map(undriven).collect();
        let mut forced = None;
        for driven in drives {
            let term = self.scaled(driven)?;
            bounded(
                std::iter::once(term.position.saturating_add(term.velocity)),
                self.scaling.order,
            )?;
            if term.position + term.velocity == 0 && p != q {
                let size = Polynomial::symbol(self.lambda);
                let zero = Polynomial::zero();
                let size = match term.drive {
                    Some((_, Quadrature::Sine)) => Complex {
                        real: zero,
                        imaginary: size.map(|number| -number),
                    },
                    _ => Complex::real(size),
                };
                forced = Some((p as i32, size));
            } else {
                terms.push(term);
            }
        }
        if still {
            terms.retain(|term| term.velocity % 2 == 0 && term.drive.is_none());
        }
        let turning =
            Polynomial::symbol(self.sigma).product(&Polynomial::constant(ratio(1, i64::from(p) * i64::from(q))));
        let scaled = Scaled {
            terms,
            linear_frequency: self.linear_frequency.clone(),
            own: q as i32,
            detuning: Some((self.small_order(), turning)),
            forced,
            order: self.scaling.order as usize,
        };
        Ok(scaled.expand(self.names.complex))
    }

    /// What `Lambda` stands for: `F/(2 (omega0^2 - Omega^2))`.
    fn forced_size(&self, drives: &[Driven]) -> Result<Option<Definition>, Refusal> {
        if self.resonance.0 == self.resonance.1 {
            return Ok(None);
        }
        for driven in drives {
            let term = self.scaled(driven)?;
            if term.position + term.velocity == 0 {
                let linear = Expr::from(&self.scaling.force.linear);
                let squared = Expr::product([self.frequency.clone(), self.frequency.clone()]);
                let below = &Expr::from(2) * &(&linear - &squared);
                // The drive stands on the left side of the equation.
                let meaning = Expr::divide(&-&driven.factor, &below)?;
                return Ok(Some(Definition {
                    symbol: self.lambda,
                    meaning,
                }));
            }
        }
        Ok(None)
    }

    fn unmarked(&self, polynomial: &Polynomial) -> Polynomial {
        let unmarked = self.scaling.unmarked(polynomial, self.names.marker);
        match (&self.root, self.scaling.force.linear.as_number()) {
            (Some(root), Some(square)) => with_square(&unmarked, root.symbol, &square),
            _ => unmarked,
        }
    }
}

/// Whether a drive reaches the motion at a resonance.
fn resonates_at(
    resonance: (u32, u32),
    oscillator: &Oscillator,
    scaling: &Scaling,
    frequency: &Expr,
    drives: &[Driven],
) -> bool {
    let Ok(question) = Question::new(oscillator, scaling, frequency, resonance) else {
        return false;
    };
    let expansion = question.expand(drives, false);
    expansion.is_ok_and(|expansion| Slow::new(&expansion, &question).is_resonant())
}

/// `a'` and `a psi'/p` as waves of the slow phase, by its multiple: cosines and sines.
struct Slow {
    amplitude: BTreeMap<u32, [Polynomial; 2]>,
    phase: BTreeMap<u32, [Polynomial; 2]>,
}

impl Slow {
    fn new(expansion: &Expansion, question: &Question) -> Self {
        let zero = || [Polynomial::zero(), Polynomial::zero()];
        let (mut amplitude, mut phase) = (BTreeMap::new(), BTreeMap::new());
        let names = &question.names;
        let p = i64::from(question.resonance.0);
        for (k, rate) in expansion.rates.iter().enumerate().skip(1) {
            let mark = names.mark(k);
            for (part, imaginary) in [(&rate.real, false), (&rate.imaginary, true)] {
                for (monomial, number) in part.terms() {
                    let turns = monomial.exponent(names.complex.own) - monomial.exponent(names.complex.conjugate) - 1;
                    let term = Polynomial::term(monomial.clone(), number * Rational::from_integer(2.into()));
                    let term = names.polar(&term).times_monomial(&mark);
                    let multiple = i64::from(turns).unsigned_abs() / p.unsigned_abs();
                    let multiple = u32::try_from(multiple).unwrap_or(u32::MAX);
                    // C e^(-i n psi): the real part is a', minus the imaginary part a psi'/p.
                    let sign = Polynomial::constant(ratio(if turns < 0 { -1 } else { 1 }, 1));
                    let minus = Polynomial::constant(ratio(-1, 1));
                    let rates = amplitude.entry(multiple).or_insert_with(zero);
                    let phases = phase.entry(multiple).or_insert_with(zero);
                    match imaginary {
                        false => {
                            rates[0].accumulate(&term);
                            phases[1].accumulate(&term.product(&sign));
                        }
                        true => {
                            rates[1].accumulate(&term.product(&sign));
                            phases[0].accumulate(&term.product(&minus));
                        }
                    }
                }
            }
        }
        // A wave that does not turn has no sine.
        for waves in [&mut amplitude, &mut phase] {
            if let Some([_, sine]) = waves.get_mut(&0) {
                *sine = Polynomial::zero();
            }
        }
        Self { amplitude, phase }
    }

    fn is_resonant(&self) -> bool {
        let moving = self.amplitude.iter().chain(&self.phase).filter(|entry| *entry.0 > 0);
        moving
            .into_iter()
            .any(|(_, waves)| waves.iter().any(|wave| !wave.is_zero()))
    }

    /// What does not turn with the phase: `P` or `Q`.
    fn still(waves: &BTreeMap<u32, [Polynomial; 2]>) -> Polynomial {
        waves.get(&0).map_or_else(Polynomial::zero, |waves| waves[0].clone())
    }

    fn turning(waves: &BTreeMap<u32, [Polynomial; 2]>) -> [Polynomial; 2] {
        let zero = || [Polynomial::zero(), Polynomial::zero()];
        waves.get(&1).cloned().unwrap_or_else(zero)
    }

    /// Whether no multiple of the phase stands in them.
    fn is_simple(&self) -> bool {
        let moving = self.amplitude.iter().chain(&self.phase).filter(|entry| *entry.0 > 1);
        moving.into_iter().all(|(_, waves)| waves.iter().all(Zero::is_zero))
    }

    fn expression(
        waves: &BTreeMap<u32, [Polynomial; 2]>,
        phase: Symbol,
        change: &dyn Fn(&Polynomial) -> Polynomial,
    ) -> Result<Expr, Refusal> {
        let mut terms = Vec::new();
        for (multiple, [cosine, sine]) in waves {
            let angle = &Expr::from(i64::from(*multiple)) * &Expr::from(phase);
            terms.push(&Expr::from(&change(cosine)) * &angle.cos()?);
            if *multiple > 0 {
                terms.push(&Expr::from(&change(sine)) * &angle.sin()?);
            }
        }
        Ok(Expr::sum(terms))
    }
}

fn answer(
    oscillator: &Oscillator,
    question: &Question,
    expansion: &Expansion,
    slow: &Slow,
    still: &Slow,
) -> Result<Solution, Refusal> {
    let (p, q) = question.resonance;
    let (names, scaling) = (&question.names, question.scaling);
    let a = names.amplitude;
    let unmarked = |polynomial: &Polynomial| question.unmarked(polynomial);
    let amplitude_rate = Slow::expression(&slow.amplitude, names.phase, &unmarked)?;
    let over = Polynomial::term(Monomial::power_of(a, -1), Rational::from_integer(p.into()));
    let phase_rate = Slow::expression(&slow.phase, names.phase, &|part| unmarked(&part.product(&over)))?;
    let (p_rational, q_rational) = (ratio(p.into(), 1), ratio(q.into(), 1));
    let linear = Expr::from(&question.linear_frequency);
    let detuning =
        (&(&Expr::number(q_rational) * question.frequency) - &(&Expr::number(p_rational) * &linear)).expand()?;
    let own = drives(&oscillator.parts()?)?.1;
    let mut definitions = question.definitions.clone();
    let sigma = Definition {
        symbol: question.sigma,
        meaning: detuning,
    };
    definitions.push(sigma.clone());
    let forced = question.forced_size(&own)?;
    definitions.extend(forced.clone());
    definitions.extend(scaling.bookkeeping.clone());
    let backbone = unmarked(&backbone(&Slow::still(&still.phase), question));
    let response = response(question, expansion, slow)?;
    let mut validity = vec![scaling.cut_note()];
    validity.push(Note::Driven {
        resonance: question.resonance,
        parametric: forced.is_none() && p != q,
        small: question.counted_small(&own)?,
        power: question.small_order(),
    });
    validity.extend(question.root.clone().map(Note::Positive));
    let derivation = derivation(
        expansion,
        scaling,
        names,
        &question.linear_frequency,
        &[amplitude_rate.clone(), phase_rate.clone()],
        Some(&response),
    )?;
    let wave = FourierSeries::cos(POLYNOMIALS, 1).product(&FourierSeries::constant(POLYNOMIALS, Polynomial::symbol(a)));
    let found = Found {
        definitions,
        law: Law::Frequency(backbone),
        displacement: wave,
        limit_cycle: None,
        modulation: Modulation {
            amplitude: a,
            phase: names.phase,
            amplitude_rate,
            phase_rate,
            small_with: scaling.small_with.clone(),
            resonance: Some(Resonance {
                driving_frequency: question.frequency.clone(),
                times_driving: q,
                times_linear: p,
                detuning: sigma,
            }),
            release: None,
            transient: None,
            steady: vec![],
            motion: None,
        },
        response: Some(response),
        validity,
        derivation,
    };
    Ok(solution(oscillator, scaling, found))
}

impl Question<'_> {
    /// What counts as small beside the small parameters of the answer: the detuning, and drives without such a parameter.
    fn counted_small(&self, drives: &[Driven]) -> Result<Vec<Expr>, Refusal> {
        let mut small = vec![Expr::from(self.sigma)];
        for driven in drives {
            let term = self.scaled(driven)?;
            let hard = term.position + term.velocity == 0 && self.resonance.0 != self.resonance.1;
            let written = std::iter::once(self.scaling.small)
                .chain(self.scaling.small_with.iter().copied())
                .any(|name| driven.factor.contains(name));
            if !hard && !written {
                small.push(driven.factor.clone());
            }
        }
        if let Some(damping) = &self.scaling.damping {
            small.push(damping.clone());
        }
        for term in &mut small {
            if term.has_leading_minus() {
                *term = -&*term;
            }
        }
        Ok(small)
    }
}

/// The frequency of the motion itself where `Q = 0` without damping and drive, in powers of the marker: `omega0 + sigma/p`.
fn backbone(still: &Polynomial, question: &Question) -> Polynomial {
    let names = &question.names;
    let order = question.scaling.order as i32;
    let (sigma, a) = (question.sigma, names.amplitude);
    let own = Monomial::power_of(sigma, 1)
        .product(&Monomial::power_of(a, 1))
        .product(&names.mark(question.small_order()));
    // Q = (sigma/p) a + rest: sigma = -p rest/a, put in until nothing changes.
    let mut rest = still.clone();
    let slope = rest.coefficient(&own);
    rest.add_term(own, -slope.clone());
    let over = Polynomial::term(
        Monomial::power_of(a, -1).product(&Monomial::power_of(names.marker, -(question.small_order() as i32))),
        if slope.is_zero() {
            Rational::zero()
        } else {
            -slope.recip()
        },
    );
    let mut detuning = Polynomial::zero();
    for _ in 0..=order {
        let next = rest
            .substitute(sigma, &detuning)
            .unwrap_or_else(Polynomial::zero)
            .product(&over);
        detuning = next.truncated(names.marker, order - question.small_order() as i32);
    }
    let p = Polynomial::constant(ratio(1, question.resonance.0.into()));
    let mut frequency = detuning.product(&p).times_monomial(&names.mark(question.small_order()));
    frequency.accumulate(&question.linear_frequency);
    frequency
}

/// Everything that follows from the slow equations of a steady motion.
fn response(question: &Question, expansion: &Expansion, slow: &Slow) -> Result<Response, Refusal> {
    let names = &question.names;
    let (sigma, a) = (question.sigma, names.amplitude);
    let unmarked = |polynomial: Polynomial| question.unmarked(&polynomial);
    let (rate, phase) = (
        unmarked(Slow::still(&slow.amplitude)),
        unmarked(Slow::still(&slow.phase)),
    );
    let turning = [Slow::turning(&slow.amplitude), Slow::turning(&slow.phase)];
    let [[rate_cos, rate_sin], [phase_cos, phase_sin]] = turning.map(|waves| waves.map(unmarked));
    let minus = |polynomial: &Polynomial| polynomial.map(|number| -number);
    let square = |polynomial: &Polynomial| polynomial.product(polynomial);
    // One wave of the phase alone: its size is all that matters.
    let one_wave = phase_sin == rate_cos && phase_cos == minus(&rate_sin)
        || phase_sin == minus(&rate_cos) && phase_cos == rate_sin;
    let (drive, relation) = match one_wave {
        true => {
            let drive = square(&rate_cos) + square(&rate_sin);
            let relation = square(&rate) + square(&phase) + minus(&drive);
            (Some(drive), relation)
        }
        false => {
            let determinant = rate_cos.product(&phase_sin) + minus(&rate_sin.product(&phase_cos));
            let cosine = rate_sin.product(&phase) + minus(&rate.product(&phase_sin));
            let sine = phase_cos.product(&rate) + minus(&rate_cos.product(&phase));
            (None, square(&cosine) + square(&sine) + minus(&square(&determinant)))
        }
    };
    let relation = slow.is_simple().then(|| without_common_powers(&relation));
    // sigma = centre + and - the root of the square of a width, where the wave is free of it and the rest linear in it.
    let by_sigma = Monomial::power_of(sigma, 1).product(&Monomial::power_of(a, 1));
    let weight = phase.coefficient(&by_sigma);
    let mut centre = phase.clone();
    centre.add_term(by_sigma, -weight.clone());
    let free = |polynomial: &Polynomial| !polynomial.symbols().contains(&sigma);
    let mut branches = None;
    let mut peak = None;
    if let Some(drive) = drive
        .as_ref()
        .filter(|drive| !weight.is_zero() && free(drive) && free(&centre) && free(&rate))
    {
        let over = Polynomial::term(Monomial::power_of(a, -1), weight.recip());
        let width = (drive.clone() + minus(&square(&rate))).product(&square(&over));
        branches = Some(Branches {
            centre: minus(&centre.product(&over)),
            width_squared: width,
        });
        peak = peak_of(&rate, drive, a);
    }
    let (folds, jumps) = relation.as_ref().map_or((vec![], None), |relation| folds(relation, a));
    let [u, v] = ["u", "v"].map(|name| fresh(name, &question.taken));
    Ok(Response {
        motion: motion(question, expansion)?,
        relation,
        branches,
        peak,
        folds,
        jumps,
        plane: Plane {
            coordinates: [u, v],
            rates: plane(question, expansion, [u, v]),
        },
    })
}

/// A relation with the powers that all terms have in common taken out.
fn without_common_powers(relation: &Polynomial) -> Polynomial {
    relation.symbols().into_iter().fold(relation.clone(), |rest, name| {
        let lowest = rest.exponent_range(name).map_or(0, |range| range.0);
        rest.times_monomial(&Monomial::power_of(name, -lowest))
    })
}

/// The largest amplitude, where `P^2 = S^2` with `P` in one power of the amplitude and `S` in none. Symbols count as positive.
fn peak_of(rate: &Polynomial, drive: &Polynomial, a: Symbol) -> Option<Expr> {
    let (monomial, number) = rate.single_term()?;
    let power = monomial.exponent(a);
    if drive.symbols().contains(&a) || power < 1 {
        return None;
    }
    let size = Polynomial::term(monomial.without(a), number.abs());
    let quotient = drive.single_term_root()?.product(&size.power(-1)?);
    Expr::power(&Expr::from(&quotient), &Expr::number(ratio(1, power.into()))).ok()
}

/// The coefficients of a polynomial in the square of the amplitude, lowest first; `None` where it has odd powers.
fn in_square(relation: &Polynomial, a: Symbol) -> Option<Vec<Polynomial>> {
    let mut coefficients: Vec<Polynomial> = vec![];
    for (monomial, number) in relation.terms() {
        let exponent = usize::try_from(monomial.exponent(a)).ok()?;
        if exponent % 2 == 1 {
            return None;
        }
        if coefficients.len() <= exponent / 2 {
            coefficients.resize(exponent / 2 + 1, Polynomial::zero());
        }
        coefficients[exponent / 2].add_term(monomial.without(a), number.clone());
    }
    Some(coefficients)
}

/// Where two steady motions meet: their squared amplitudes by the detuning, and the discriminant that vanishes there.
fn folds(relation: &Polynomial, a: Symbol) -> (Vec<Expr>, Option<Polynomial>) {
    let Some(coefficients) = in_square(relation, a) else {
        return (vec![], None);
    };
    let product = |factors: &[&Polynomial], number: i64| {
        let start = Polynomial::constant(ratio(number, 1));
        factors.iter().fold(start, |product, factor| product.product(factor))
    };
    match coefficients.as_slice() {
        [c, b, a] => (
            vec![],
            Some(without_common_powers(&(product(&[b, b], 1) + product(&[a, c], -4)))),
        ),
        [d, c, b, a] => {
            let discriminant = product(&[a, b, c, d], 18)
                + product(&[b, b, b, d], -4)
                + product(&[b, b, c, c], 1)
                + product(&[a, c, c, c], -4)
                + product(&[a, a, d, d], -27);
            // 3 a z^2 + 2 b z + c = 0
            let under = product(&[b, b], 1) + product(&[a, c], -3);
            let places = || {
                let over = product(&[a], 3).power(-1)?;
                let (outside, inside) = squares_apart(&under)?;
                let root = Expr::from(&inside).sqrt().ok()?;
                let middle = Expr::from(&product(&[b, &over], -1));
                let width = &Expr::from(&outside.product(&over)) * &root;
                Some(vec![&middle - &width, &middle + &width])
            };
            (places().unwrap_or_default(), Some(without_common_powers(&discriminant)))
        }
        _ => (vec![], None),
    }
}

/// A polynomial as the square of a single term and what stays under the root.
fn squares_apart(polynomial: &Polynomial) -> Option<(Polynomial, Polynomial)> {
    let mut outside = Monomial::one();
    for name in polynomial.symbols() {
        let (lowest, _) = polynomial.exponent_range(name)?;
        outside = outside.product(&Monomial::power_of(name, lowest.div_euclid(2)));
    }
    let inside = polynomial.times_monomial(&outside.power(-2));
    Some((Polynomial::term(outside, ratio(1, 1)), inside))
}

/// `x(t)` in `t`, the amplitude and the phase.
fn motion(question: &Question, expansion: &Expansion) -> Result<Expr, Refusal> {
    let names = &question.names;
    let p = i64::from(question.resonance.0);
    let omega_t = question.frequency * &Expr::symbol("t");
    let psi = Expr::from(names.phase);
    let mut waves: BTreeMap<(i64, i64), [Polynomial; 2]> = BTreeMap::new();
    for (k, wave) in expansion.displacement.iter().enumerate() {
        for (m, value) in wave.iter().filter(|entry| *entry.0 >= 0) {
            for (part, imaginary) in [(&value.real, false), (&value.imaginary, true)] {
                for (monomial, number) in part.terms() {
                    let turns =
                        i64::from(monomial.exponent(names.complex.own) - monomial.exponent(names.complex.conjugate));
                    let factor = if *m == 0 { ratio(1, 1) } else { ratio(2, 1) };
                    let term = names.polar(&Polynomial::term(monomial.clone(), number * factor));
                    let term = question.unmarked(&term.times_monomial(&names.mark(k)));
                    let zero = || [Polynomial::zero(), Polynomial::zero()];
                    let entry = waves.entry((i64::from(*m), turns)).or_insert_with(zero);
                    entry[usize::from(imaginary)].accumulate(&term);
                }
            }
        }
    }
    // e^(i m phi) B^j Bc^l with phi = Omega t/p and B = (a/2) e^(-i psi/p).
    let mut terms = Vec::new();
    for ((m, turns), [real, imaginary]) in &waves {
        let angle = &(&Expr::number(ratio(*m, p)) * &omega_t) - &(&Expr::number(ratio(*turns, p)) * &psi);
        terms.push(&Expr::from(real) * &angle.cos()?);
        if !imaginary.is_zero() {
            terms.push(&(-&Expr::from(imaginary)) * &angle.sin()?);
        }
    }
    Ok(Expr::sum(terms))
}

/// The slow equations in `u = a cos(psi/p)` and `v = -a sin(psi/p)`, that is `2 B = u + i v`: without a singular origin.
fn plane(question: &Question, expansion: &Expansion, [u, v]: [Symbol; 2]) -> [Polynomial; 2] {
    let names = &question.names;
    let half = Polynomial::constant(ratio(1, 2));
    let of = |sign: i64| Complex {
        real: Polynomial::symbol(u).product(&half),
        imaginary: Polynomial::symbol(v).product(&Polynomial::constant(ratio(sign, 2))),
    };
    let (own, conjugate) = (of(1), of(-1));
    let mut sum = Complex::zero();
    for (k, rate) in expansion.rates.iter().enumerate().skip(1) {
        for (part, imaginary) in [(&rate.real, false), (&rate.imaginary, true)] {
            for (monomial, number) in part.terms() {
                let rest = monomial.without(names.complex.own).without(names.complex.conjugate);
                let rest = rest.product(&names.mark(k));
                let mut term = Complex::real(Polynomial::term(rest, number * Rational::from_integer(2.into())));
                for (name, value) in [(names.complex.own, &own), (names.complex.conjugate, &conjugate)] {
                    for _ in 0..monomial.exponent(name) {
                        term = term.product(value);
                    }
                }
                sum.accumulate(&if imaginary { term.times_i() } else { term });
            }
        }
    }
    [question.unmarked(&sum.real), question.unmarked(&sum.imaginary)]
}

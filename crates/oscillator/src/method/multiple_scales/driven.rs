//! Driven motions: near a resonance the phase between drive and motion changes as slowly as the
//! amplitude.
//!
//! Reference: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, sections 4.1
//! (primary, superharmonic and subharmonic resonances of a cubic force), 4.2 (of a quadratic one)
//! and 5.7 (parametric excitation).
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
//! For a steady motion both vanish; the phase is eliminated by `cos^2 + sin^2 = 1`, which leaves
//! the frequency-response equation. To first order it is `P^2 + Q^2 = S^2`, with `S` the
//! contribution of the drive.

use std::collections::{BTreeMap, BTreeSet};

use super::derivation::{averaged_lines, derivation};
use super::names::ExpansionSymbols;
use super::scaling::{Scaling, bounded, has_linear_damping, has_quadratic_terms, scaling};
use super::slow_times::{DrivenTerm, MultipleScalesExpansion, ScaledProblem};
use super::slow_waves::{SlowRates, backbone, response};
use super::undriven;
use crate::exact::rational::ratio;
use crate::exact::{ComplexPolynomial as Complex, Polynomial};
use crate::expr::Expr;
use crate::method::drive::{Drive, Driven, Quadrature};
use crate::method::driven_answer::DrivenMotion;
use crate::method::lindstedt_poincare::{LinearPart, with_square};
use crate::method::resonance::{by_distance, is_near, is_ratio, ratio_of};
use crate::method::{Options, Reason, Refusal};
use crate::oscillator::{Oscillator, OscillatorError, Parts, PerturbedForce};
use crate::solution::{AmplitudeConvention, Definition, Law, Method, Note, Solution};
use crate::symbol::{Symbol, fresh};

/// The highest order of a driven motion in a parameter; twice that in the amplitude.
const HIGHEST: u32 = 3;

/// The slow equations of a driven motion, its frequency-response equation and what follows from it.
///
/// # Errors
/// A drive that is not a single wave, a resonance that the equation does not have, or any error of
/// an expansion.
pub(super) fn solve(
    oscillator: &Oscillator,
    parts: &Parts,
    options: &Options,
) -> Result<Solution, Refusal> {
    let in_amplitude = || {
        let options = Options {
            small: Some(AmplitudeConvention::Initial.symbol().to_string()),
            ..options.clone()
        };
        expanded(oscillator, parts, &options)
    };
    if !options.say_what_is_small(oscillator)
        && bends_at_second_order(oscillator, parts).unwrap_or(false)
        && let Ok(mut found) = in_amplitude()
    {
        found.validity.push(Note::QuadraticTerms);
        return Ok(found);
    }
    let found = expanded(oscillator, parts, options);
    let refused = |refusal: &Refusal| {
        matches!(refusal.reason, Reason::Oscillator(OscillatorError::NotPolynomial(_)))
    };
    // A force that is not a polynomial may be one for small motions.
    match options.small.is_none() && found.as_ref().is_err_and(refused) {
        true => in_amplitude().or(found),
        false => found,
    }
}

/// Whether quadratic terms stand beside a linear damping, once the drive is left out.
fn bends_at_second_order(oscillator: &Oscillator, parts: &Parts) -> Result<bool, Refusal> {
    let free = undriven_oscillator(oscillator, parts)?;
    let parts = free.parts()?;
    Ok(has_linear_damping(&free, &parts) && has_quadratic_terms(&free))
}

fn undriven_oscillator(oscillator: &Oscillator, parts: &Parts) -> Result<Oscillator, Refusal> {
    let mut free = oscillator.clone();
    free.force = (&oscillator.force - &parts.forcing).expand()?;
    Ok(free)
}

/// Expands the motion in the small parameter that is asked for, or in the likeliest one.
fn expanded(
    oscillator: &Oscillator,
    parts: &Parts,
    options: &Options,
) -> Result<Solution, Refusal> {
    let drive = Drive::from_parts(parts, oscillator, Method::MultipleScales)?;
    let free = undriven_oscillator(oscillator, parts)?;
    let parts = free.parts()?;
    let scaling_of = |order: Option<u32>| -> Result<Scaling, Refusal> {
        let options = Options { order, ..options.clone() };
        let scaling = scaling(&free, &parts, &options, [1, 2], [HIGHEST, 2 * HIGHEST])?;
        let mut scaling = scaling.spelt_out(&oscillator.names());
        scaling.force.write_with_frequency(&oscillator.names());
        Ok(scaling)
    };
    let scaling = scaling_of(options.order)?;
    if scaling.is_below_balance() {
        let lowest = u32::try_from(scaling.small_order).unwrap_or(u32::MAX);
        return Err(Reason::BelowBalance(lowest).to(Method::MultipleScales));
    }
    let drive = match scaling.marker {
        Some(_) => drive,
        None => drive.in_small_motions(oscillator.coordinate, scaling.order + 1),
    };
    let asked = DrivenRequest {
        method: Method::MultipleScales,
        oscillator,
        drive: &drive,
        resonance: options.resonance,
    };
    let mut answer = asked.answer(&scaling);
    if let Ok(answer) = &mut answer
        && (scaling.marker.is_some(), scaling.order) == (true, 1)
        && has_quadratic_terms(&free)
    {
        answer.validity.push(Note::QuadraticTermsLeftOut);
    }
    if let Ok(answer) = &mut answer
        && !has_nonlinear_terms(&scaling.force)
        && !is_linear(&free, &parts)
    {
        answer.validity.push(Note::NonlinearTermsLeftOut);
    }
    if options.order.is_some() || !answer.as_ref().is_err_and(is_of_resonance) {
        return answer;
    }
    // A higher order may contain the resonance if one order does not.
    let highest = HIGHEST.saturating_mul(u32::try_from(scaling.small_order).unwrap_or(1));
    for order in scaling.order + 1..=highest {
        if let Some(found) = asked.answer_near(&scaling_of(Some(order))?) {
            return found;
        }
    }
    answer
}

/// Whether a force of some order has a term that is not linear.
fn has_nonlinear_terms(force: &PerturbedForce) -> bool {
    force.terms.iter().any(|term| term.position + term.velocity > 1)
}

/// Whether a force is linear in the coordinate and the velocity.
fn is_linear(oscillator: &Oscillator, parts: &Parts) -> bool {
    let own = [oscillator.coordinate, oscillator.velocity()];
    let slopes = [parts.restoring.differentiate(own[0]), parts.damping.differentiate(own[1])];
    let is_constant = |slope: &Result<Expr, _>| {
        slope.as_ref().is_ok_and(|slope| own.iter().all(|name| !slope.contains(*name)))
    };
    slopes.iter().all(is_constant)
}

/// Whether a refusal concerns a resonance that does not exist or is far away.
pub(in crate::method) fn is_of_resonance(refusal: &Refusal) -> bool {
    matches!(refusal.reason, Reason::NoResonance { .. } | Reason::FarFromResonance { .. })
}

/// A driven motion to be expanded, and the method that requests it.
pub(in crate::method) struct DrivenRequest<'a> {
    pub(in crate::method) method: Method,
    pub(in crate::method) oscillator: &'a Oscillator,
    pub(in crate::method) drive: &'a Drive,
    /// Omega : omega0, where one is asked for.
    pub(in crate::method) resonance: Option<(u32, u32)>,
}

impl DrivenRequest<'_> {
    /// The ratio of the frequencies, where they are numbers and no resonance is asked for.
    fn frequency_ratio(&self, scaling: &Scaling) -> Option<f64> {
        match self.resonance {
            Some(_) => None,
            None => ratio_of(&self.drive.frequency, &scaling.force.linear_in_full()),
        }
    }

    fn force(&self) -> Option<&Driven> {
        let mut terms = self.drive.terms.iter();
        terms.find(|driven| driven.is_force(self.oscillator.coordinate))
    }

    /// The resonances that may be meant, the likeliest first.
    fn candidates(&self, scaling: &Scaling) -> Vec<(u32, u32)> {
        match (self.resonance, self.frequency_ratio(scaling)) {
            (Some(asked), _) => vec![asked],
            (None, Some(ratio)) => by_distance(self.drive.resonances(), ratio),
            (None, None) => {
                // The first drive that is a force decides, or else the first drive.
                let first = self.force().or(self.drive.terms.first());
                let below = first.map_or(1, |driven| driven.multiple);
                match self.force() {
                    None if below.is_multiple_of(2) => vec![(1, below / 2), (1, below)],
                    None => vec![(2, below), (1, below)],
                    Some(_) => vec![(1, below)],
                }
            }
        }
    }

    /// Whether the drive acts on the motion at a resonance.
    pub(in crate::method) fn drives_resonance(
        &self,
        resonance: (u32, u32),
        scaling: &Scaling,
    ) -> bool {
        if !is_ratio(resonance) {
            return false;
        }
        let Ok(question) = DrivenProblem::new(self, scaling, resonance) else {
            return false;
        };
        let expansion = question.expand(false);
        expansion.is_ok_and(|expansion| SlowRates::new(&expansion, &question).is_resonant())
    }

    /// The answer at the likeliest resonance.
    ///
    /// # Errors
    /// The drive acts at no resonance, or at none that is near; or a linear motion without damping
    /// is driven at its own frequency.
    pub(in crate::method) fn answer(&self, scaling: &Scaling) -> Result<Solution, Refusal> {
        let candidates = self.candidates(scaling);
        let first = candidates.first().copied().unwrap_or((1, 1));
        let reaches = |candidate: &(u32, u32)| self.drives_resonance(*candidate, scaling);
        let resonance = candidates.iter().copied().find(reaches).unwrap_or(first);
        if is_driven_at_own_frequency(scaling, self.drive, resonance) {
            let term = self.force().or(self.drive.terms.first());
            let term = term.map_or_else(Expr::zero, |driven| driven.term.clone());
            return Err(Reason::ResonanceWithoutDamping.to(self.method).about(&term));
        }
        let found = self.answer_at(resonance, scaling)?.ok_or_else(|| {
            let others = self.drive.resonances().into_iter().filter(reaches).collect();
            let asked = resonance;
            Reason::NoResonance { asked, others }.to(self.method)
        })?;
        if let Some(ratio) = self.frequency_ratio(scaling) {
            is_near(resonance, ratio, self.method)?;
        }
        Ok(found)
    }

    /// The answer at the likeliest resonance that is not far away; `None` if the drive acts at
    /// none.
    pub(in crate::method) fn answer_near(
        &self,
        scaling: &Scaling,
    ) -> Option<Result<Solution, Refusal>> {
        let near = self.frequency_ratio(scaling);
        let is_near =
            |resonance| near.is_none_or(|ratio| is_near(resonance, ratio, self.method).is_ok());
        let mut candidates = self.candidates(scaling).into_iter();
        let found = candidates
            .find(|candidate| is_near(*candidate) && self.drives_resonance(*candidate, scaling))?;
        self.answer_at(found, scaling).transpose()
    }

    /// The answer at a resonance; `None` if the drive does not act on the motion there.
    pub(in crate::method) fn answer_at(
        &self,
        resonance: (u32, u32),
        scaling: &Scaling,
    ) -> Result<Option<Solution>, Refusal> {
        if !is_ratio(resonance) {
            return Ok(None);
        }
        let question = DrivenProblem::new(self, scaling, resonance)?;
        let expansion = question.expand(false)?;
        let slow = SlowRates::new(&expansion, &question);
        if !slow.is_resonant() {
            return Ok(None);
        }
        let still = question.expand(true)?;
        let found = DrivenExpansion { still: SlowRates::new(&still, &question), slow, expansion };
        question.answer(&found).map(Some)
    }
}

/// Whether a linear force without damping is driven at its own frequency.
fn is_driven_at_own_frequency(scaling: &Scaling, drive: &Drive, (p, q): (u32, u32)) -> bool {
    let own = drive.terms.iter().find(|driven| p * driven.multiple == q);
    let squared =
        own.and_then(|driven| drive.frequency_of(driven).integer_power(2).ok()?.expand().ok());
    scaling.force.terms.is_empty()
        && squared.is_some_and(|squared| squared == scaling.force.linear_in_full())
}

/// A driven motion at one resonance, to be expanded.
pub(super) struct DrivenProblem<'a> {
    method: Method,
    pub(super) oscillator: &'a Oscillator,
    pub(super) scaling: &'a Scaling,
    pub(super) drive: &'a Drive,
    /// Omega : omega0.
    pub(super) resonance: (u32, u32),
    pub(super) linear_frequency: Polynomial,
    root: Option<Definition>,
    definitions: Vec<Definition>,
    pub(super) names: ExpansionSymbols,
    pub(super) sigma: Symbol,
    /// The symbols `Lambda` of the cosine and of the sine of each drive far from resonance, by its
    /// multiple.
    lambda: BTreeMap<u32, [Symbol; 2]>,
    pub(super) taken: Vec<Symbol>,
}

impl<'a> DrivenProblem<'a> {
    fn new(
        asked: &DrivenRequest<'a>,
        scaling: &'a Scaling,
        resonance: (u32, u32),
    ) -> Result<Self, Refusal> {
        let (oscillator, drive) = (asked.oscillator, asked.drive);
        let LinearPart { frequency: linear_frequency, root, definitions, taken } =
            LinearPart::new(&scaling.force, oscillator);
        let (p, q) = resonance;
        let hard = drive.terms.iter().filter(|driven| driven.is_force(oscillator.coordinate));
        let hard: BTreeSet<u32> =
            hard.map(|driven| driven.multiple).filter(|multiple| p * multiple != q).collect();
        let several = hard.len() > 1;
        let lambda = |multiple: u32| {
            let number = if several { multiple.to_string() } else { String::new() };
            ["", "_s"].map(|ending| fresh(&format!("Lambda{number}{ending}"), &taken))
        };
        Ok(Self {
            method: asked.method,
            oscillator,
            scaling,
            drive,
            resonance,
            linear_frequency,
            root,
            definitions,
            names: ExpansionSymbols::new(&taken, oscillator.coordinate, scaling.marker),
            sigma: fresh("sigma", &taken),
            lambda: hard.into_iter().map(|multiple| (multiple, lambda(multiple))).collect(),
            taken,
        })
    }

    /// The order at which detuning, damping and a small drive enter.
    pub(super) fn small_order(&self) -> usize {
        self.scaling.small_order
    }

    /// A driven term with its power of the small parameter.
    fn scaled(&self, driven: &Driven) -> Result<DrivenTerm, Refusal> {
        let own = [self.oscillator.coordinate, self.oscillator.velocity()];
        let not_polynomial =
            || Refusal::from(OscillatorError::NotPolynomial(driven.term.clone().into()));
        let polynomial = driven.factor.to_polynomial(&mut |_| None)?.ok_or_else(not_polynomial)?;
        let (monomial, number) = polynomial.single_term().ok_or_else(not_polynomial)?;
        let exponent = |name| u32::try_from(monomial.exponent(name)).map_err(|_| not_polynomial());
        let (position, velocity) = (exponent(own[0])?, exponent(own[1])?);
        let mut rest = monomial.without(own[0]).without(own[1]);
        let small =
            || std::iter::once(self.scaling.small).chain(self.scaling.small_with.iter().copied());
        let written: i32 = small().map(|name| rest.exponent(name)).sum();
        if let Some(marker) = self.scaling.marker {
            rest = rest.without(marker);
        }
        // A drive without a small parameter counts as small as the terms that balance it.
        let above = driven.above as usize;
        let natural = match self.scaling.marker {
            None => ((position + velocity) as usize).saturating_sub(1 + above),
            Some(_) => 0,
        };
        let order = match usize::try_from(written) {
            Ok(written) if written > 0 && self.scaling.marker.is_some() => written,
            // A term of the series of a drive whose first term is a force that is not small.
            _ if above > 0 && self.forces(driven) => above,
            _ => natural.max(self.small_order()) + above,
        };
        let coefficient = Polynomial::term(rest, number.clone());
        let names = self.oscillator.names();
        Ok(DrivenTerm {
            order,
            position,
            velocity,
            coefficient: self.scaling.force.written_with_frequency(coefficient, &names),
            drive: Some(((self.resonance.0 * driven.multiple) as i32, driven.quadrature)),
        })
    }

    /// The expansion; `still` leaves out the damping and small drives.
    fn expand(&self, still: bool) -> Result<MultipleScalesExpansion, Refusal> {
        let (p, q) = self.resonance;
        let mut terms: Vec<DrivenTerm> = self.scaling.force.terms.iter().map(undriven).collect();
        let mut forced: BTreeMap<u32, Complex> = BTreeMap::new();
        for driven in &self.drive.terms {
            if let Some(lambda) = self.lambda.get(&driven.multiple).filter(|_| self.is_hard(driven))
            {
                let [cosine, sine] = lambda.map(Polynomial::symbol);
                let forced = forced.entry(driven.multiple).or_insert_with(Complex::zero);
                match driven.quadrature {
                    Quadrature::Cosine => forced.real = cosine,
                    Quadrature::Sine => forced.imaginary = sine.map(|number| -number),
                }
                continue;
            }
            let term = self.scaled(driven)?;
            if term.order > self.scaling.order as usize && driven.above > 0 {
                continue;
            }
            bounded(
                std::iter::once(term.position.saturating_add(term.velocity)),
                self.scaling.order,
            )?;
            terms.push(term);
        }
        if still {
            terms.retain(|term| term.velocity % 2 == 0 && term.drive.is_none());
        }
        let turning = Polynomial::symbol(self.sigma)
            .product(&Polynomial::constant(ratio(1, i64::from(p) * i64::from(q))));
        let scaled = ScaledProblem {
            terms,
            linear_frequency: self.linear_frequency.clone(),
            own: q as i32,
            detuning: Some((self.small_order(), turning)),
            forced: forced
                .into_iter()
                .map(|(multiple, size)| ((p * multiple) as i32, size))
                .collect(),
            order: self.scaling.order as usize,
        };
        Ok(scaled.expand(self.names.complex))
    }

    /// Whether the series of this drive begins with a force far from resonance.
    fn forces(&self, driven: &Driven) -> bool {
        let mut beginnings = self.drive.terms.iter().filter(|own| own.above == 0);
        beginnings.any(|own| own.term == driven.term && self.is_hard(own))
    }

    /// Whether a drive is a force far from resonance, which is not small.
    fn is_hard(&self, driven: &Driven) -> bool {
        let (p, q) = self.resonance;
        driven.is_force(self.oscillator.coordinate) && p * driven.multiple != q
    }

    /// The definitions of `Lambda`, `F/(2 (omega0^2 - Omega^2))`, for the cosines and the sines of
    /// drives far from resonance.
    fn forced_sizes(&self) -> Result<Vec<Definition>, Refusal> {
        let mut found = vec![];
        let symbols = self.lambda.iter().flat_map(|(multiple, symbols)| {
            let quadratures = [Quadrature::Cosine, Quadrature::Sine].into_iter().zip(symbols);
            quadratures.map(|(quadrature, symbol)| (*multiple, quadrature, *symbol))
        });
        for (multiple, quadrature, symbol) in symbols {
            let hard = self.drive.terms.iter().filter(|driven| self.is_hard(driven));
            let own: Vec<&Driven> = hard
                .filter(|driven| (driven.multiple, driven.quadrature) == (multiple, quadrature))
                .collect();
            let Some(first) = own.first() else {
                continue;
            };
            let linear = match &self.root {
                Some(root) => Expr::from(root.symbol).integer_power(2)?,
                None => Expr::from(&self.scaling.force.linear),
            };
            let frequency = self.drive.frequency_of(first);
            let squared = Expr::product([frequency.clone(), frequency]);
            let below = &Expr::from(2) * &(&linear - &squared);
            // The drive stands on the left side of the equation.
            let factors = own.iter().map(|driven| driven.factor.clone());
            let meaning = Expr::divide(&-&Expr::sum(factors), &below)?;
            found.push(Definition { symbol, meaning });
        }
        Ok(found)
    }

    pub(super) fn unmarked(&self, polynomial: &Polynomial) -> Polynomial {
        let unmarked = self.scaling.unmarked(polynomial, self.names.marker);
        match (&self.root, self.scaling.force.linear.as_number()) {
            (Some(root), Some(square)) => with_square(&unmarked, root.symbol, &square),
            _ => unmarked,
        }
    }
}

/// The result of the expansion of a driven motion.
struct DrivenExpansion {
    expansion: MultipleScalesExpansion,
    slow: SlowRates,
    /// The rates without damping and drive.
    still: SlowRates,
}

impl DrivenProblem<'_> {
    fn answer(&self, found: &DrivenExpansion) -> Result<Solution, Refusal> {
        let DrivenExpansion { expansion, slow, still } = found;
        let (p, q) = self.resonance;
        let (names, scaling, drive) = (&self.names, self.scaling, self.drive);
        let rates = slow.rates(self)?;
        let (p_rational, q_rational) = (ratio(p.into(), 1), ratio(q.into(), 1));
        let linear = Expr::from(&self.linear_frequency);
        let detuning = (&(&Expr::number(q_rational) * &drive.frequency)
            - &(&Expr::number(p_rational) * &linear))
            .expand()?;
        let mut definitions = self.definitions.clone();
        let sigma = Definition { symbol: self.sigma, meaning: detuning };
        definitions.push(sigma.clone());
        let forced = self.forced_sizes()?;
        let no_force =
            drive.terms.iter().all(|driven| !driven.is_force(self.oscillator.coordinate));
        let parametric = forced.is_empty() && no_force;
        definitions.extend(drive.definitions.iter().cloned());
        definitions.extend(forced);
        definitions.extend(scaling.bookkeeping.clone());
        let backbone = self.unmarked(&backbone(&SlowRates::constant_part(&still.phase), self));
        let averaged = self.method == Method::Averaging;
        // Averaging has its motion to one order less than its rates.
        let highest = if averaged { scaling.order - 1 } else { scaling.order };
        let response = response(self, expansion, slow, highest as usize)?;
        let mut validity = vec![scaling.cut_note()];
        validity.push(Note::Driven {
            resonance: self.resonance,
            parametric,
            small: self.counted_small(),
            power: self.small_order(),
            nearest: drive.nearest(self.resonance),
        });
        validity.extend(self.root.clone().map(Note::Positive));
        let derivation = match averaged {
            true => averaged_lines(self, expansion, &rates, &response)?,
            false => derivation(
                expansion,
                scaling,
                names,
                &self.linear_frequency,
                &rates,
                Some(&response),
            )?,
        };
        let motion = DrivenMotion {
            method: self.method,
            order: scaling.order,
            small: (scaling.small, scaling.small_with.clone()),
            definitions,
            backbone: Law::Frequency(backbone),
            rates,
            phase: names.phase,
            drive,
            resonance: self.resonance,
            detuning: sigma,
            response,
            validity,
            derivation,
        };
        Ok(motion.into_solution(self.oscillator))
    }

    /// The quantities that count as small in addition to the small parameters of the answer: the
    /// detuning, and drives without such a parameter.
    fn counted_small(&self) -> Vec<Expr> {
        let mut small = vec![Expr::from(self.sigma)];
        for driven in self.drive.terms.iter().filter(|driven| driven.above == 0) {
            let written = std::iter::once(self.scaling.small)
                .chain(self.scaling.small_with.iter().copied())
                .any(|name| driven.factor.contains(name));
            if !self.is_hard(driven) && !written {
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
        small
    }
}

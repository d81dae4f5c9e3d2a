//! Linear equations with constant coefficients, free or driven by waves of any frequencies: their
//! exact motion from rest at `x = A`.
//!
//! Reference: L. Meirovitch, *Fundamentals of Vibrations*, McGraw-Hill 2001, chapters 2 and 3.
//!
//! ```text
//! x'' + c x' + k x = sum of G cos(W t + phi)
//! free, c^2 < 4 k:  x = a cos(psi),  a' = -c a/2,  psi' = omega_d,  omega_d = sqrt(k - c^2/4)
//! a drive:          X = G ((k - W^2) cos(W t + phi) + c W sin(W t + phi))/((k - W^2)^2 + c^2 W^2);   a sine a quarter of a turn later
//! in resonance,     c = 0, W^2 = k:  X = G t sin(W t + phi)/(2 W)
//! x = sum of X + exp(-c t/2) (C1 cos(omega_d t) + C2 sin(omega_d t)),      x(0) = A, x'(0) = 0
//! c^2 = 4 k:        exp(-c t/2) (C1 + C2 t);      c^2 > 4 k:  C1 exp(l1 t) + C2 exp(l2 t)
//! ```

use std::collections::BTreeMap;

use super::drive::{HarmonicExcitation, Quadrature};
use super::one_term::unsolved;
use super::{Options, Reason, Refusal, transient};
use crate::derivation::DerivationLine;
use crate::exact::Polynomial;
use crate::expr::{Expr, ExprError, Function};
use crate::oscillator::Oscillator;
use crate::solution::modulation::Release;
use crate::solution::note::{ExactBy, LinearDrive};
use crate::solution::{
    AmplitudeConvention, ClosedForm, Definition, Law, Method, Modulation, Note, Response, Solution,
};
use crate::symbol::{Symbol, fresh};

/// A linear equation with constant coefficients that something damps, feeds or drives.
pub(super) struct Linear {
    /// `c` of `c x'`.
    damping: Expr,
    /// `k` of `k x`.
    stiffness: Expr,
    /// The drives on the left side.
    waves: Vec<HarmonicExcitation>,
}

/// Whether a linear force `k x` with a constant `k` that pulls back is all there is.
///
/// # Errors
/// The equation cannot be taken apart.
pub(super) fn is_free_and_linear(oscillator: &Oscillator) -> Result<bool, Refusal> {
    let parts = oscillator.parts()?;
    if ![&parts.damping, &parts.forcing, &parts.inertia].into_iter().all(Expr::is_zero) {
        return Ok(false);
    }
    let x = Expr::from(oscillator.coordinate);
    let stiffness = parts.restoring.differentiate(oscillator.coordinate)?.expand()?;
    let is_all = (&parts.restoring - &(&stiffness * &x)).expand()?.is_zero();
    let is_constant = !stiffness.contains(oscillator.coordinate);
    Ok(is_all && is_constant && !stiffness.is_zero() && !stiffness.has_leading_minus())
}

impl Linear {
    /// `None` if a term is not linear, a coefficient is not constant, a drive is not a wave, or no
    /// term drives or damps.
    ///
    /// # Errors
    /// The equation cannot be taken apart.
    pub(super) fn new(oscillator: &Oscillator) -> Result<Option<Self>, Refusal> {
        let parts = oscillator.parts()?;
        let own = [oscillator.coordinate, oscillator.velocity()];
        let constant = |part: &Expr, by: Symbol| -> Result<Option<Expr>, ExprError> {
            let coefficient = part.differentiate(by)?.expand()?;
            let left = (part - &(&coefficient * &Expr::from(by))).expand()?;
            let is_constant = left.is_zero() && own.iter().all(|name| !coefficient.contains(*name));
            Ok(is_constant.then_some(coefficient))
        };
        let still = parts.damping.is_zero() && parts.forcing.is_zero();
        if still || !parts.inertia.is_zero() || own.iter().any(|name| parts.forcing.contains(*name))
        {
            return Ok(None);
        }
        let coefficients = (constant(&parts.damping, own[1])?, constant(&parts.restoring, own[0])?);
        let (Some(damping), Some(stiffness)) = coefficients else {
            return Ok(None);
        };
        let waves = parts.forcing.terms().iter().filter(|term| !term.is_zero());
        let waves: Result<Vec<HarmonicExcitation>, _> =
            waves.map(|term| HarmonicExcitation::new(term, Method::Exact)).collect();
        let restores = !stiffness.is_zero() && !stiffness.has_leading_minus();
        Ok(waves.ok().filter(|_| restores).map(|waves| Self { damping, stiffness, waves }))
    }

    /// The exact answer.
    ///
    /// # Errors
    /// The amplitude is asked for by a convention that does not apply.
    pub(super) fn solve(
        &self,
        oscillator: &Oscillator,
        options: &Options,
    ) -> Result<Solution, Refusal> {
        let rate = Expr::divide(&self.damping, &Expr::from(2))?;
        let square = (&self.stiffness - &(&rate * &rate)).expand()?;
        let sign = match square.is_zero() {
            true => 0.0,
            // With parameters the motion is taken to be underdamped.
            false => square.evaluate(&BTreeMap::new()).map_or(1.0, f64::signum),
        };
        let mut solution = unsolved(oscillator, options, Method::Exact, 0);
        solution.validity.push(Note::Exact(ExactBy::Linear));
        if sign > 0.0 && self.waves.is_empty() {
            if options.amplitude == Some(AmplitudeConvention::Initial) {
                return Err(Reason::SlowAmplitude.to(Method::Exact));
            }
            self.decay(oscillator, &rate, &square, solution)
        } else {
            if options.amplitude == Some(AmplitudeConvention::FirstHarmonic) {
                return Err(Reason::Convention.to(Method::Exact));
            }
            self.in_time(oscillator, &rate, &square, sign, solution)
        }
    }

    /// The slow equations of an underdamped free motion: amplitude and phase.
    fn decay(
        &self,
        oscillator: &Oscillator,
        rate: &Expr,
        square: &Expr,
        mut solution: Solution,
    ) -> Result<Solution, Refusal> {
        let mut taken = oscillator.names();
        let frequency = named("omega_d", square.sqrt()?, &mut solution.definitions, &mut taken);
        let a = AmplitudeConvention::FirstHarmonic.symbol();
        let start = Expr::from(AmplitudeConvention::Initial.symbol());
        let lag = Expr::function(Function::Atan, vec![Expr::divide(rate, &frequency)?])?;
        let mut release = Release {
            amplitude: Expr::divide(&(&start * &self.stiffness.sqrt()?), &frequency)?,
            phase: -&lag,
        };
        let rates = [(-&(rate * &Expr::from(a))).expand()?, frequency.clone()];
        let (defined, transient) =
            transient::from_release(a, [&rates[0], &rates[1]], &mut release, &taken);
        solution.validity.extend(solution.definitions.clone().into_iter().map(Note::Positive));
        solution.definitions.extend(defined);
        solution.law = law(&frequency)?;
        solution.amplitude = AmplitudeConvention::FirstHarmonic;
        solution.small_parameter = a;
        solution.displacement = super::one_term::cosine(Polynomial::symbol(a));
        let [amplitude_rate, phase_rate] = rates;
        if !amplitude_rate.has_leading_minus() {
            solution.validity.push(Note::Grows);
        }
        let characteristic = characteristic(oscillator, &self.damping, &self.stiffness)?;
        solution.derivation = vec![characteristic];
        solution.modulation = Some(Modulation {
            amplitude: a,
            phase: fresh("psi", &taken),
            amplitude_rate,
            phase_rate,
            small_with: vec![],
            resonance: None,
            release: Some(release),
            transient,
            steady: vec![],
            motion: None,
        });
        Ok(solution)
    }

    /// The motion from rest at `x = A`, as a function of time.
    fn in_time(
        &self,
        oscillator: &Oscillator,
        rate: &Expr,
        square: &Expr,
        sign: f64,
        mut solution: Solution,
    ) -> Result<Solution, Refusal> {
        let t = Symbol::new("t");
        let time = Expr::from(t);
        let mut taken = oscillator.names();
        let mut forced = vec![];
        for wave in &self.waves {
            let (motion, note) = self.forced_by(wave)?;
            forced.push(motion);
            solution.validity.extend(note);
        }
        let forced = Expr::sum(forced);
        let at_start = |part: &Expr| part.substitute(t, &Expr::zero());
        let start = Expr::from(AmplitudeConvention::Initial.symbol());
        let place = &start - &at_start(&forced)?;
        let speed = -&at_start(&forced.differentiate(t)?)?;
        let decay = |rate: &Expr| Expr::function(Function::Exp, vec![(-&(rate * &time)).expand()?]);
        let free = if sign > 0.0 {
            let frequency = named("omega_d", square.sqrt()?, &mut solution.definitions, &mut taken);
            solution.validity.extend(solution.definitions.clone().into_iter().map(Note::Positive));
            solution.law = law(&frequency)?;
            let first = named("C1", place, &mut solution.definitions, &mut taken);
            let second_value = Expr::divide(&(&speed + &(rate * &first)), &frequency)?;
            let second = named("C2", second_value, &mut solution.definitions, &mut taken);
            let angle = &frequency * &time;
            decay(rate)? * (&first * &angle.cos()? + &second * &angle.sin()?)
        } else if sign == 0.0 {
            solution.law = law(&Expr::zero())?;
            let first = named("C1", place, &mut solution.definitions, &mut taken);
            let second_value = (&speed + &(rate * &first)).expand()?;
            let second = named("C2", second_value, &mut solution.definitions, &mut taken);
            decay(rate)? * (&first + &(&second * &time))
        } else {
            solution.law = law(&Expr::zero())?;
            let root = (-square).sqrt()?;
            let [slower, faster] = [(rate - &root).expand()?, (rate + &root).expand()?];
            // C1 + C2 = x(0), l1 C1 + l2 C2 = x'(0), with l = -slower, -faster.
            let twice = Expr::from(2) * &root;
            let first_value = Expr::divide(&(&speed + &(&faster * &place)).expand()?, &twice)?;
            let second_value = Expr::divide(&-&(&speed + &(&slower * &place)).expand()?, &twice)?;
            let first = named("C1", first_value, &mut solution.definitions, &mut taken);
            let second = named("C2", second_value, &mut solution.definitions, &mut taken);
            &first * &decay(&slower)? + &second * &decay(&faster)?
        };
        let dies_out = !self.damping.is_zero() && !self.damping.has_leading_minus();
        if dies_out && !self.waves.is_empty() {
            solution.validity.push(Note::LinearDrive(LinearDrive::Steady {
                coordinate: oscillator.coordinate,
                motion: forced.clone(),
                amplitude: match self.waves.as_slice() {
                    [only] => Some(self.steady_amplitude(only)?),
                    _ => None,
                },
            }));
        }
        if self.damping.has_leading_minus() {
            solution.validity.push(Note::Grows);
        }
        solution.derivation = vec![characteristic(oscillator, &self.damping, &self.stiffness)?];
        solution.response = Some(Response {
            motion: forced + free,
            relation: None,
            branches: None,
            peak: None,
            folds: vec![],
            jumps: None,
            closed: None,
            plane: None,
        });
        Ok(solution)
    }

    /// The amplitude of the steady motion under one wave.
    fn steady_amplitude(&self, wave: &HarmonicExcitation) -> Result<Expr, ExprError> {
        let spring = (&self.stiffness - &(&wave.rate * &wave.rate)).expand()?;
        let drag = (&self.damping * &wave.rate).expand()?;
        let size =
            if wave.factor.has_leading_minus() { -&wave.factor } else { wave.factor.clone() };
        Expr::divide(&size, &(&spring * &spring + &drag * &drag).sqrt()?)
    }

    /// The particular solution of a wave, and a note on it.
    fn forced_by(&self, wave: &HarmonicExcitation) -> Result<(Expr, Option<Note>), Refusal> {
        let size = -&wave.factor;
        let time = Expr::symbol("t");
        let angle = &(&wave.rate * &time) + &wave.phase;
        let [cos, sin] = [angle.cos()?, angle.sin()?];
        // The wave itself, and the one that follows it a quarter of a turn later.
        let (wave_itself, quarter_later) = match wave.quadrature {
            Quadrature::Cosine => (cos, sin),
            Quadrature::Sine => (sin, -&cos),
        };
        let squared = (&wave.rate * &wave.rate).expand()?;
        let spring = (&self.stiffness - &squared).expand()?;
        if self.damping.is_zero() {
            if spring.is_zero() {
                let below = Expr::from(2) * &wave.rate;
                let growing = &Expr::divide(&size, &below)? * &(&time * &quarter_later);
                let term = &size * &wave_itself;
                return Ok((growing, Some(Note::LinearDrive(LinearDrive::Grows { term }))));
            }
            let note = spring.as_number().is_none().then(|| {
                Note::LinearDrive(LinearDrive::Detuned {
                    square: squared,
                    stiffness: self.stiffness.clone(),
                })
            });
            return Ok((&Expr::divide(&size, &spring)? * &wave_itself, note));
        }
        let drag = (&self.damping * &wave.rate).expand()?;
        let below = &spring * &spring + &drag * &drag;
        let sum = &spring * &wave_itself + &drag * &quarter_later;
        Ok((&Expr::divide(&size, &below)? * &sum, None))
    }
}

/// The equation that the exponents of a free motion solve.
fn characteristic(
    oscillator: &Oscillator,
    damping: &Expr,
    stiffness: &Expr,
) -> Result<DerivationLine, Refusal> {
    let exponent = Expr::from(fresh("lambda", &oscillator.names()));
    let left = exponent.integer_power(2)? + damping * &exponent + stiffness.clone();
    Ok(DerivationLine::equation(left, Expr::zero()).because("a free motion exp(lambda*t) has"))
}

/// The frequency as a law.
fn law(frequency: &Expr) -> Result<Law, ExprError> {
    Ok(match frequency.to_polynomial(&mut |_| None)? {
        Some(polynomial) => Law::Frequency(polynomial),
        None => Law::Closed(ClosedForm { squared: false, value: frequency.clone() }),
    })
}

/// A value, replaced by a name if it is more than a number or a symbol.
fn named(
    wanted: &str,
    value: Expr,
    definitions: &mut Vec<Definition>,
    taken: &mut Vec<Symbol>,
) -> Expr {
    if value.as_number().is_some() || value.as_symbol().is_some() {
        return value;
    }
    let symbol = fresh(wanted, taken);
    taken.push(symbol);
    definitions.push(Definition { symbol, meaning: value });
    Expr::from(symbol)
}

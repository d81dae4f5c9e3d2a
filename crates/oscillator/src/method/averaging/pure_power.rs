//! Averaging along the true motion of a restoring force that is one power of the coordinate: there
//! is no linear restoring force, and the undamped motion is not harmonic, but has the same shape at
//! every amplitude.
//!
//! References: N. N. Bogoliubov, Y. A. Mitropolsky, *Asymptotic Methods in the Theory of Non-Linear
//! Oscillations*, Gordon and Breach 1961, section 25 (slow change of the energy); V. I.
//! Arnold, *Mathematical Methods of Classical Mechanics*, 2nd ed., Springer 1989, section 52; L.
//! Cveticanin, *Strongly Nonlinear Oscillators*, Springer 2014, chapter 4; NIST Digital Library of
//! Mathematical Functions 5.12.1 (the Beta integral).
//!
//! ```text
//! x'' + k sgn(x) |x|^n + d(x, x') = 0,   x = r chi(theta),   x'^2 = (2 k/(n+1)) (r^(n+1) - |x|^(n+1)) between two turns
//! theta' = omega(r) = sqrt(pi k (n+1)/2) r^((n-1)/2) Gamma(1/2 + s)/Gamma(s),   s = 1/(n+1)
//! E = k r^(n+1)/(n+1),   E' = k r^n r' = -(mean of d x')
//! d = c |x|^p |x'|^q sgn(x'):   r' = -(c/k) (2 k/(n+1))^((q+1)/2) r^(p + (q+1)(n+1)/2 - n) B((p+1) s, q/2 + 1)/B(s, 1/2)
//! d = c x':                     r' = -2 c r/(n+3), that is the action r^((n+3)/2) decays as exp(-c t)
//! ```
//!
//! A damping that is odd in the coordinate does no work over a period. With `chi_1` the first
//! harmonic of the motion that turns at one, `a = chi_1 r` is the amplitude of the first harmonic;
//! the ratios of the other harmonics to it are numbers, found by quadrature.

use std::collections::BTreeMap;

use num_traits::{One as _, Signed as _, Zero as _};

use super::small_terms::letters;
use super::{DerivationLetters, action};
use crate::conservative::force::CentredForce;
use crate::conservative::power::Power;
use crate::decimal::rounded;
use crate::derivation::DerivationLine;
use crate::exact::rational::ratio;
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::{Expr, ExprError, Function};
use crate::method::exact::of_power;
use crate::method::exact_motion::motion_about;
use crate::method::{Options, Reason, Refusal, transient};
use crate::oscillator::{Oscillator, Parts};
use crate::series::FourierSeries;
use crate::solution::modulation::Release;
use crate::solution::note::Truncation;
use crate::solution::{
    AmplitudeConvention, ClosedForm, Definition, Law, Method, Modulation, Note, Solution,
};
use crate::symbol::{Symbol, fresh};

/// A restoring force `k sgn(x) |x|^n`.
pub(super) struct PurePower {
    /// `k`.
    stiffness: Expr,
    /// `n`, which is not one.
    exponent: Rational,
}

impl PurePower {
    /// The restoring force of a damped motion, if it is one power, whose exponent is a number above
    /// -1 other than one; `None` for any other.
    pub(super) fn from_parts(parts: &Parts, coordinate: Symbol) -> Option<Self> {
        if parts.damping.is_zero() || !parts.inertia.is_zero() || !parts.forcing.is_zero() {
            return None;
        }
        let (stiffness, power) = taken_apart(&parts.restoring, [coordinate])
            .map(|(outside, [power])| (outside, power))?;
        let exponent = power.exponent.as_number()?.clone();
        let restores = power.odd
            && exponent > ratio(-1, 1)
            && !exponent.is_one()
            && !stiffness.has_leading_minus();
        restores.then_some(Self { stiffness, exponent })
    }

    /// `1/(n+1)`.
    fn share(&self) -> Rational {
        (&self.exponent + Rational::one()).recip()
    }

    /// The contribution of a damping term to `r'`: the power of `r`, and its coefficient; `None` if
    /// the mean has no closed form.
    fn drain(&self, term: &Expr, coordinate: Symbol) -> Option<(Rational, Expr)> {
        let own = [coordinate, coordinate.derivative()];
        let (outside, [position, velocity]) = taken_apart(term, own)?;
        let [p, q] = [position.exponent.as_number()?, velocity.exponent.as_number()?];
        if !velocity.odd || p.is_negative() || q.is_negative() {
            return None;
        }
        if position.odd {
            return Some((Rational::zero(), Expr::zero()));
        }
        let (one, two) = (Rational::one(), ratio(2, 1));
        let (share, half) = (self.share(), ratio(1, 2));
        let work = (q + &one) * &half;
        let power = p + &work / &share - &self.exponent;
        let [first, second] = [(p + &one) * &share, q * &half + &one];
        let both = &first + &second;
        let betas = gamma_quotient(&[first, second, &share + &half], &[both, share.clone(), half])?;
        let doubled = (&self.stiffness * &Expr::number(two * &share)).expand().ok()?;
        let speed = Expr::power(&doubled, &Expr::number(work)).ok()?;
        let size = Expr::divide(&(&outside * &speed), &self.stiffness).ok()?;
        Some((power, -(&size * &betas)))
    }
}

/// A term as a constant and a power of each variable; `None` if they stand elsewhere.
fn taken_apart<const N: usize>(term: &Expr, variables: [Symbol; N]) -> Option<(Expr, [Power; N])> {
    let (number, factors) = term.factors();
    let mut outside = Expr::number(number);
    let mut powers = [(); N].map(|()| Power::one());
    for factor in factors {
        let mut inside =
            variables.iter().zip(&mut powers).filter(|(name, _)| factor.contains(**name));
        match (inside.next(), inside.next()) {
            (None, _) => outside = &outside * factor,
            (Some((name, power)), None) => power.absorb(factor, *name).then_some(())?,
            (Some(_), Some(_)) => return None,
        }
    }
    Some((outside, powers))
}

/// A quotient of products of Gamma functions of positive fractions, by `Gamma(z + 1) = z Gamma(z)`
/// and `Gamma(1/2) = sqrt(pi)`.
fn gamma_quotient(above: &[Rational], below: &[Rational]) -> Option<Expr> {
    let mut factor = Rational::one();
    let mut left: BTreeMap<Rational, i64> = BTreeMap::new();
    for (arguments, sign) in [(above, 1), (below, -1)] {
        for argument in arguments {
            let mut rest = argument.clone();
            if !rest.is_positive() {
                return None;
            }
            while rest > Rational::one() {
                rest -= Rational::one();
                factor = if sign > 0 { factor * &rest } else { factor / &rest };
            }
            *left.entry(rest).or_insert(0) += sign;
        }
    }
    let mut quotient = Expr::number(factor);
    for (argument, times) in left {
        let value = match argument {
            argument if argument.is_one() => continue,
            argument if argument == ratio(1, 2) => Expr::pi().sqrt().ok()?,
            argument => Expr::function(Function::Gamma, vec![Expr::number(argument)]).ok()?,
        };
        quotient = quotient * value.integer_power(times).ok()?;
    }
    Some(quotient)
}

/// The motion in units of its first harmonic, and that harmonic of the motion that turns at one.
struct Shape {
    first: Rational,
    /// The coefficients of `cos(k theta)` over that of `cos(theta)`, rounded.
    harmonics: Vec<Rational>,
}

impl Shape {
    /// The constants of the force `sgn(x) |x|^n`.
    fn new(restoring: &PurePower, oscillator: &Oscillator, parts: &Parts) -> Option<Self> {
        /// The highest harmonic, and the least that is written.
        const MOST: usize = 15;
        const LEAST: f64 = 1e-10;
        let unit = Expr::divide(&parts.restoring, &restoring.stiffness).ok()?.expand().ok()?;
        let force =
            CentredForce::new(&unit, oscillator.coordinate, &Expr::zero(), &BTreeMap::new(), 1.0)?;
        let (_, cosine) = motion_about(&force, 1.0).ok()?;
        let first = *cosine.get(1)?;
        let over = |(k, value): (usize, &f64)| match k % 2 == 1 && (value / first).abs() >= LEAST {
            true => rounded(value / first),
            false => Rational::zero(),
        };
        Some(Self {
            first: rounded(first),
            harmonics: cosine.iter().enumerate().take(MOST + 1).map(over).collect(),
        })
    }

    /// The last harmonic that is written.
    fn last_harmonic(&self) -> usize {
        self.harmonics.iter().rposition(|value| !value.is_zero()).unwrap_or(1)
    }

    /// The motion whose first harmonic has this amplitude.
    fn motion(&self, amplitude: Symbol) -> FourierSeries<Polynomials> {
        let amplitude = Polynomial::symbol(amplitude);
        let waves = self.harmonics.iter().cloned();
        let waves: Vec<Polynomial> =
            waves.map(|value| Polynomial::constant(value).product(&amplitude)).collect();
        let sines = vec![Polynomial::zero(); waves.len()];
        FourierSeries::from_parts(POLYNOMIALS, waves, sines)
    }
}

/// The symbols of an answer.
struct AnswerSymbols {
    taken: Vec<Symbol>,
    /// `a`, the amplitude of the first harmonic.
    amplitude: Symbol,
    /// `psi`.
    phase: Symbol,
    /// `chi_1`, the first harmonic of the motion that turns at one.
    first: Symbol,
    /// `r`, where the motion turns.
    turning: Symbol,
}

impl AnswerSymbols {
    fn avoiding(oscillator: &Oscillator) -> Self {
        let taken = oscillator.names();
        let [first, turning] = ["chi", "r"].map(|name| fresh(name, &taken));
        Self {
            amplitude: AmplitudeConvention::FirstHarmonic.symbol(),
            phase: DerivationLetters::avoiding(&taken).phase,
            first,
            turning,
            taken,
        }
    }
}

/// The slow equations in the amplitude of the first harmonic, and their derivation.
struct SlowEquations {
    amplitude_rate: Expr,
    phase_rate: Expr,
    derivation: Vec<DerivationLine>,
}

impl SlowEquations {
    /// # Errors
    /// A damping term without a closed mean.
    fn from_pure_power(
        oscillator: &Oscillator,
        parts: &Parts,
        restoring: &PurePower,
        names: &AnswerSymbols,
    ) -> Result<Self, Refusal> {
        let AnswerSymbols { amplitude, phase, first, turning, .. } = *names;
        let (mut rates, mut turning_rates) = (vec![], vec![]);
        for term in parts.damping.terms() {
            let Some((power, size)) = restoring.drain(term, oscillator.coordinate) else {
                return Err(Reason::NoProjection.to(Method::Averaging).about(term));
            };
            let at = |base: Symbol, power: Rational| {
                Expr::power(&Expr::from(base), &Expr::number(power))
            };
            turning_rates.push(&size * &at(turning, power.clone())?);
            rates.push(size * at(amplitude, power.clone())? * at(first, Rational::one() - power)?);
        }
        let amplitude_rate = Expr::sum(rates).expand()?;
        let frequency = of_power(&restoring.stiffness, &Expr::number(restoring.exponent.clone()))?;
        let turn = |size: &Expr| frequency.substitute(AmplitudeConvention::Initial.symbol(), size);
        let phase_rate = turn(&Expr::divide(&Expr::from(amplitude), &Expr::from(first))?)?;
        let phase_rate = spread(&phase_rate)?;
        let derivation = vec![
            DerivationLine::equation(turning.derivative(), Expr::sum(turning_rates))
                .because("the mean of the work that damping takes, over k*r^n"),
            DerivationLine::equation(phase.derivative(), turn(&Expr::from(turning))?)
                .because("the exact frequency of the motion that turns at r"),
            DerivationLine::equation(amplitude, Expr::from(first) * Expr::from(turning))
                .because("its first harmonic"),
            DerivationLine::equation(amplitude.derivative(), amplitude_rate.clone()),
            DerivationLine::equation(phase.derivative(), phase_rate.clone()),
        ];
        Ok(Self { amplitude_rate, phase_rate, derivation })
    }

    /// Whether the amplitude only grows.
    fn always_grows(&self) -> bool {
        let mut terms = self.amplitude_rate.terms().iter();
        !self.amplitude_rate.is_zero() && terms.all(|term| !term.has_leading_minus())
    }

    /// The slow equations with the motion from its release, and the definitions of the names that
    /// it introduces.
    fn released(
        &self,
        names: &AnswerSymbols,
        small_with: Vec<Symbol>,
    ) -> (Modulation, Vec<Definition>) {
        let mut release = Release {
            amplitude: Expr::from(names.first) * Expr::from(AmplitudeConvention::Initial.symbol()),
            phase: Expr::zero(),
        };
        let used: Vec<Symbol> = names.taken.iter().copied().chain([names.first]).collect();
        let rates = [&self.amplitude_rate, &self.phase_rate];
        let (named, transient) =
            transient::from_release(names.amplitude, rates, &mut release, &used);
        let modulation = Modulation {
            amplitude: names.amplitude,
            phase: names.phase,
            steady: transient::steady(names.amplitude, &self.amplitude_rate),
            amplitude_rate: self.amplitude_rate.clone(),
            phase_rate: self.phase_rate.clone(),
            small_with,
            resonance: None,
            release: Some(release),
            transient,
            motion: None,
        };
        (modulation, named)
    }
}

/// The decay, or growth, of a motion in a force of one power, to first order in the damping.
///
/// # Errors
/// A damping term without a closed mean, an order above one.
pub(super) fn solve(
    oscillator: &Oscillator,
    parts: &Parts,
    restoring: &PurePower,
    options: &Options,
) -> Result<Solution, Refusal> {
    refuse_other_orders(parts, options)?;
    let names = AnswerSymbols::avoiding(oscillator);
    let Some(shape) = Shape::new(restoring, oscillator, parts) else {
        return Err(Reason::NoProjection.to(Method::Averaging).about(&parts.restoring));
    };
    let slow = SlowEquations::from_pure_power(oscillator, parts, restoring, &names)?;
    let (small, small_with, cut) = small_in_words(oscillator, parts)?;
    let harmonic = shape.last_harmonic();
    let mut validity = vec![cut, Note::AlongTrueMotion { harmonic }];
    validity.extend(action::notes(oscillator, parts));
    validity.extend(slow.always_grows().then_some(Note::Grows));
    let (modulation, named) = slow.released(&names, small_with);
    let first = Definition { symbol: names.first, meaning: Expr::number(shape.first.clone()) };
    Ok(Solution {
        equation: oscillator.equation(),
        method: Method::Averaging,
        order: 1,
        degrees: None,
        small_parameter: small,
        amplitude: AmplitudeConvention::FirstHarmonic,
        parameters: oscillator.parameters.clone(),
        definitions: std::iter::once(first).chain(named).collect(),
        equilibrium: Expr::zero(),
        law: Law::Closed(ClosedForm { squared: false, value: slow.phase_rate }),
        displacement: shape.motion(names.amplitude),
        limit_cycle: None,
        modulation: Some(modulation),
        response: None,
        numerical: true,
        closed_motion: None,
        convergence: None,
        validity,
        steps: vec![],
        derivation: slow.derivation,
    })
}

/// Refuses orders other than the first, and an amplitude that is not that of the slow equations.
fn refuse_other_orders(parts: &Parts, options: &Options) -> Result<(), Refusal> {
    let refuse = |reason: Reason| Err(reason.to(Method::Averaging));
    match options.order {
        Some(0) => refuse(Reason::LowestOrder(1)),
        Some(order) if order > 1 => {
            refuse(Reason::FirstOrderOfPower).map_err(|refusal| refusal.about(&parts.restoring))
        }
        _ if options.amplitude == Some(AmplitudeConvention::Initial) => {
            refuse(Reason::SlowAmplitude)
        }
        _ => Ok(()),
    }
}

/// Powers of quotients as products of powers, so that the amplitude stands alone; factors without
/// symbols stay together.
fn spread(expression: &Expr) -> Result<Expr, ExprError> {
    let (number, factors) = expression.factors();
    let mut product = Expr::number(number);
    for factor in factors {
        let (base, exponent) = factor.base_and_exponent();
        let (number, inner) = base.factors();
        let (constant, inner): (Vec<&Expr>, Vec<&Expr>) =
            inner.iter().partition(|part| part.symbols().is_empty());
        let constant =
            Expr::product([Expr::number(number)].into_iter().chain(constant.into_iter().cloned()));
        product = product * Expr::power(&constant, &exponent)?;
        for part in inner {
            let (base, power) = part.base_and_exponent();
            product = product * Expr::power(&base, &(&power * &exponent).expand()?)?;
        }
    }
    Ok(product)
}

/// The small parameters: those that are factors of the damping alone, or else a name for all of it.
fn small_in_words(
    oscillator: &Oscillator,
    parts: &Parts,
) -> Result<(Symbol, Vec<Symbol>, Note), ExprError> {
    let restoring: Vec<&Expr> = parts.restoring.terms().iter().collect();
    let damping: Vec<&Expr> = parts.damping.terms().iter().collect();
    let found = letters(&restoring, &damping, &oscillator.parameters, None).unwrap_or_default();
    let marks = found.is_empty().then(Expr::one);
    let mut names = found.into_iter();
    let first = names.next().unwrap_or_else(|| fresh("delta", &oscillator.names()));
    let others: Vec<Symbol> = names.collect();
    let small = std::iter::once(first).chain(others.iter().copied()).collect();
    let cut = Note::Cut(Truncation::Truncated { small, order: 1, marks });
    Ok((first, others, cut))
}

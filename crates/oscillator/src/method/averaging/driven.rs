//! Averaging of driven motions: to first order for every force whose projections have a closed
//! form, to second order, and at superharmonic and subharmonic resonances, for polynomials.
//!
//! References: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, sections 4.1.1
//! and 5.7; J. P. Den Hartog, *Forced vibrations with combined Coulomb and viscous friction*, Trans.
//! ASME 53 (1931) 107-115, for the least force that moves a mass held by dry friction.
//!
//! ```text
//! x = a cos(theta), x' = -a omega0 sin(theta), theta = (Omega t - psi)/p,   Omega = p omega0 + sigma,   all else small
//! 2 omega0 a' = S[g],   psi' = sigma - p C[g]/(2 omega0 a)       g the small terms, the drive among them
//! F cos(Omega t) near 1:1      a' gains F sin(psi)/(2 omega0), psi' gains F cos(psi)/(2 omega0 a)
//! ```
//!
//! A drive acts on the motion at this order if the product of its wave and the powers of `x` and
//! `x'` that multiply it has a first harmonic. Elsewhere, and to second order, the amplitude of the
//! first harmonic and its phase are expanded as those of multiple scales are: with that amplitude
//! both methods have the same series, here with the motion to one order less than the rates. A
//! resonance that does not appear at one order, such as the parametric resonance 1:1, is left to
//! the next one.

use num_traits::{One as _, ToPrimitive as _, Zero as _};

use super::small_terms::SmallTerms;
use super::{DerivationLetters, HIGHEST, Projected, Series, small_in_words};
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::exact::{POLYNOMIALS, Polynomial, Rational};
use crate::expr::{Expr, ExprError};
use crate::method::drive::{Drive, Driven, Quadrature};
use crate::method::driven_answer::DrivenMotion;
use crate::method::frequency_response::FrequencyResponse;
use crate::method::multiple_scales::driven::{DrivenRequest, is_of_resonance};
use crate::method::multiple_scales::scaling::{Scaling, bounded};
use crate::method::resonance::{by_distance, is_near, is_ratio, ratio_of};
use crate::method::{Options, Reason, Refusal, not_polynomial};
use crate::oscillator::{Oscillator, OscillatorError, Parts};
use crate::solution::response::{ClosedRelation, Response};
use crate::solution::{AmplitudeConvention, ClosedForm, Definition, Law, Method, Note, Solution};
use crate::symbol::{Symbol, fresh};

/// The highest power of the coordinate or the velocity that may multiply a wave.
const HIGHEST_POWER: u32 = 24;

/// The slow equations of a driven motion and its steady amplitudes.
///
/// # Errors
/// A drive that is not a single wave, a resonance that the equation does not have, a term without a
/// closed projection, or to second order one that is not a polynomial.
pub(super) fn solve(
    oscillator: &Oscillator,
    parts: &Parts,
    options: &Options,
) -> Result<Solution, Refusal> {
    let refuse = |reason: Reason| Err(reason.to(Method::Averaging));
    match options.order {
        Some(0) => return refuse(Reason::LowestOrder(1)),
        Some(order) if order > HIGHEST => {
            return refuse(Reason::HighestOrder(HIGHEST));
        }
        _ => {}
    }
    if options.amplitude == Some(AmplitudeConvention::Initial) {
        return refuse(Reason::ConventionOfFirstHarmonic);
    }
    let drive = Drive::from_parts(parts, oscillator, Method::Averaging)?;
    let mut free = oscillator.clone();
    free.force = (&oscillator.force - &parts.forcing).expand()?;
    let averaged = DrivenAveraging {
        oscillator,
        free: &free,
        small: SmallTerms::from_oscillator(&free, options)?,
        asked: DrivenRequest {
            method: Method::Averaging,
            oscillator,
            drive: &drive,
            resonance: options.resonance,
        },
    };
    if let Some(order @ HIGHEST) = options.order {
        return averaged.asked.answer(&averaged.scaling(order)?);
    }
    let projected = averaged.first_order();
    if !projected.as_ref().is_err_and(is_of_resonance) {
        return projected;
    }
    // Drives that do not appear in the projections may appear in an expansion of a polynomial, also
    // to second order if no order is asked for.
    for order in 1..=options.order.unwrap_or(HIGHEST) {
        let Ok(scaling) = averaged.scaling(order) else {
            break;
        };
        if let Some(found) = averaged.asked.answer_near(&scaling) {
            return found;
        }
    }
    projected
}

/// A driven motion that is to be averaged.
struct DrivenAveraging<'a> {
    oscillator: &'a Oscillator,
    /// The equation without its drive.
    free: &'a Oscillator,
    small: SmallTerms,
    asked: DrivenRequest<'a>,
}

impl DrivenAveraging<'_> {
    /// The small terms as those of an expansion.
    ///
    /// # Errors
    /// A term that is not a polynomial, no restoring force, or powers that are too high.
    fn scaling(&self, order: u32) -> Result<Scaling, Refusal> {
        let mut force = match self.small.expand(order) {
            Ok(force) => force,
            Err(
                OscillatorError::NotPolynomial(_)
                | OscillatorError::Taylor(_)
                | OscillatorError::NoEquilibrium(_),
            ) => {
                self.small.linear_part()?;
                let force = self.small.without_linear()?;
                return Err(not_polynomial(&force, self.free.coordinate, Method::Averaging));
            }
            Err(error) => return Err(error.into()),
        };
        let powers = force.terms.iter().map(|term| term.position + term.velocity);
        bounded(powers, order)?;
        force.write_with_frequency(&self.oscillator.names());
        let (small, small_with, _) = small_in_words(&self.small, order);
        Ok(Scaling {
            force,
            marker: Some(self.small.delta()),
            marks: Some(Rational::one()),
            small,
            small_with,
            bookkeeping: None,
            damping: None,
            small_order: 1,
            order,
        })
    }

    /// The first order by projections.
    fn first_order(&self) -> Result<Solution, Refusal> {
        let refuse = |reason: Reason| Err(reason.to(Method::Averaging));
        let (oscillator, drive) = (self.oscillator, self.asked.drive);
        let a = AmplitudeConvention::FirstHarmonic.symbol();
        let projected = Projected::new(self.free, &self.small, &Expr::from(a))?;
        let near = match self.asked.resonance {
            Some(_) => None,
            None => ratio_of(&drive.frequency, &self.small.linear_part()?.linear_in_full()),
        };
        let forces = drive.terms.iter().any(|driven| driven.is_force(oscillator.coordinate));
        let candidates = match (self.asked.resonance, near) {
            (Some(asked), _) => vec![asked],
            (None, Some(ratio)) => by_distance(drive.resonances(), ratio),
            (None, None) if forces => vec![(1, 1)],
            (None, None) => vec![(2, 1), (1, 1)],
        };
        // Waves of several frequencies contain several multiples of the phase, which only
        // expansions treat.
        let one_frequency = drive.terms.iter().all(|driven| driven.multiple == 1);
        let waves_at = |(p, q): (u32, u32)| match q {
            1 if one_frequency && is_ratio((p, q)) => {
                waves(drive, oscillator, &projected.omega0, p).map(Some)
            }
            _ => Ok(None),
        };
        for resonance in candidates.iter().copied() {
            let Some(waves) = waves_at(resonance)?.filter(DriveWaves::is_nonzero) else {
                continue;
            };
            if let Some(ratio) = near {
                is_near(resonance, ratio, Method::Averaging)?;
            }
            let undamped = projected.terms.is_zero() && drive.frequency == projected.omega0;
            if let (true, Some(driven)) = (undamped, drive.terms.first()) {
                let refusal = Reason::ResonanceWithoutDamping.to(Method::Averaging);
                return Err(refusal.about(&driven.term));
            }
            return ResonantEquation::new(oscillator, &self.small, drive, projected, resonance.0)
                .answer(&waves);
        }
        let scaling = self.scaling(1).ok();
        let mut others = vec![];
        for resonance in drive.resonances() {
            let projected = waves_at(resonance)?.is_some_and(|waves| waves.is_nonzero());
            if projected
                || scaling
                    .as_ref()
                    .is_some_and(|scaling| self.asked.drives_resonance(resonance, scaling))
            {
                others.push(resonance);
            }
        }
        let asked = candidates.first().copied().unwrap_or((1, 1));
        refuse(Reason::NoResonance { asked, others })
    }
}

/// Contributions of a drive to `2 omega0 a'` and to `2 omega0 a (theta' - omega0)`: the
/// coefficients of cos(psi) and sin(psi).
struct DriveWaves {
    sine: [Expr; 2],
    cosine: [Expr; 2],
}

impl DriveWaves {
    /// Whether the drive acts on the first harmonic.
    fn is_nonzero(&self) -> bool {
        self.sine.iter().chain(&self.cosine).any(|wave| !wave.is_zero())
    }
}

/// The first harmonics of a drive with `Omega t = p theta + psi`.
///
/// # Errors
/// A drive multiplied by a factor that is not a power of the coordinate and its velocity.
fn waves(
    drive: &Drive,
    oscillator: &Oscillator,
    omega0: &Expr,
    p: u32,
) -> Result<DriveWaves, Refusal> {
    let a = Expr::from(AmplitudeConvention::FirstHarmonic.symbol());
    let mut sums = [[vec![], vec![]], [vec![], vec![]]];
    for driven in &drive.terms {
        let no_projection = || Reason::NoProjection.to(Method::Averaging).about(&driven.term);
        let (size, powers) = powers(driven, oscillator.coordinate).ok_or_else(no_projection)?;
        let size = &size
            * &(a.integer_power((powers[0] + powers[1]).into())?
                * omega0.integer_power(powers[1].into())?);
        let along = Series::cos(POLYNOMIALS, 1)
            .power(powers[0])
            .product(&Series::sin(POLYNOMIALS, 1).times(-1).power(powers[1]));
        // cos(p theta + psi) = cos(p theta) cos(psi) - sin(p theta) sin(psi), and the sine
        // likewise.
        let [in_phase, across] =
            [Series::cos(POLYNOMIALS, p as usize), Series::sin(POLYNOMIALS, p as usize)];
        let by_psi = match driven.quadrature {
            Quadrature::Cosine => [in_phase, across.times(-1)],
            Quadrature::Sine => [across, in_phase],
        };
        for (k, wave) in by_psi.iter().enumerate() {
            let product = along.product(wave);
            for (sum, part) in sums.iter_mut().zip([product.sine(1), product.cosine(1)]) {
                sum[k].push(&size * &Expr::from(&part.constant_term()));
            }
        }
    }
    let [sine, cosine] = sums.map(|parts| parts.map(|terms| Expr::sum(terms).expand()));
    let both = |[cos, sin]: [Result<Expr, ExprError>; 2]| -> Result<[Expr; 2], ExprError> {
        Ok([cos?, sin?])
    };
    Ok(DriveWaves { sine: both(sine)?, cosine: both(cosine)? })
}

/// The factor of a wave as a constant and whole powers of coordinate and velocity; `None` if it has
/// another form.
fn powers(driven: &Driven, coordinate: Symbol) -> Option<(Expr, [u32; 2])> {
    let own = [coordinate, coordinate.derivative()];
    let (number, factors) = driven.factor.factors();
    let (mut size, mut powers) = (Expr::number(number), [0, 0]);
    for factor in factors {
        let (base, exponent) = factor.base_and_exponent();
        match own.iter().position(|&name| base.as_symbol() == Some(name)) {
            Some(place) => {
                let exponent = exponent.as_number().filter(|exponent| exponent.is_integer())?;
                let exponent = exponent.to_integer().to_u32()?;
                powers[place] += Some(exponent).filter(|exponent| *exponent <= HIGHEST_POWER)?;
            }
            None if own.iter().any(|&name| factor.contains(name)) => return None,
            None => size = &size * factor,
        }
    }
    Some((size, powers))
}

/// A driven equation at a resonance.
struct ResonantEquation<'a> {
    oscillator: &'a Oscillator,
    small: &'a SmallTerms,
    drive: &'a Drive,
    projected: Projected,
    /// Omega : omega0 near `p`.
    p: u32,
    a: Symbol,
    sigma: Symbol,
    phase: Symbol,
}

impl<'a> ResonantEquation<'a> {
    fn new(
        oscillator: &'a Oscillator,
        small: &'a SmallTerms,
        drive: &'a Drive,
        projected: Projected,
        p: u32,
    ) -> Self {
        let defined = projected.definitions.iter().chain(&drive.definitions);
        let defined = defined.map(|definition| definition.symbol);
        let taken: Vec<Symbol> = oscillator.names().into_iter().chain(defined).collect();
        Self {
            oscillator,
            small,
            drive,
            projected,
            p,
            a: AmplitudeConvention::FirstHarmonic.symbol(),
            sigma: fresh("sigma", &taken),
            phase: fresh("psi", &taken),
        }
    }

    /// Divides an expression by `2 omega0`.
    fn over_twice_omega0(&self, expression: &Expr) -> Result<Expr, ExprError> {
        Expr::divide(expression, &(Expr::from(2) * &self.projected.omega0))?.expand()
    }

    fn answer(self, waves: &DriveWaves) -> Result<Solution, Refusal> {
        let (a, p) = (Expr::from(self.a), Expr::from(i64::from(self.p)));
        let rate = self.over_twice_omega0(&self.projected.sine)?;
        let bend = self.over_twice_omega0(&self.projected.cosine)?;
        // a psi'/p
        let phase = (Expr::divide(&(Expr::from(self.sigma) * &a), &p)? - &bend).expand()?;
        let halves = |waves: &[Expr; 2], sign: i64| -> Result<[Expr; 2], ExprError> {
            let of = |wave: &Expr| (Expr::from(sign) * self.over_twice_omega0(wave)?).expand();
            Ok([of(&waves[0])?, of(&waves[1])?])
        };
        let turning = [halves(&waves.sine, 1)?, halves(&waves.cosine, -1)?];
        let angle = Expr::from(self.phase);
        let [cos, sin] = [angle.cos()?, angle.sin()?];
        let moving = turning.each_ref().map(|[by_cos, by_sin]| by_cos * &cos + by_sin * &sin);
        let amplitude_rate = &rate + &moving[0];
        let over = Expr::divide(&p, &a)?;
        let each = |sum: &Expr| (sum * &over).expand();
        let phase_rate =
            each(&phase)? + each(&(&turning[1][0] * &cos))? + each(&(&turning[1][1] * &sin))?;
        let backbone = (&self.projected.omega0 + &Expr::divide(&bend, &a)?).expand()?;
        let response = self.response([&rate, &phase], &turning, &bend)?;
        let derivation = self.derivation([&amplitude_rate, &phase_rate], &response)?;
        let mut notes = self.notes();
        notes.extend(self.least_force(&rate, &turning[0])?);
        let (first, small_with, cut) = small_in_words(self.small, 1);
        let detuning = (&self.drive.frequency - &(&p * &self.projected.omega0)).expand()?;
        let sigma = Definition { symbol: self.sigma, meaning: detuning };
        let mut definitions = self.projected.definitions.clone();
        definitions.extend(self.drive.definitions.iter().cloned());
        definitions.push(sigma.clone());
        let motion = DrivenMotion {
            method: Method::Averaging,
            order: 1,
            small: (first, small_with),
            definitions,
            backbone: match backbone.to_polynomial(&mut |_| None)? {
                Some(frequency) => Law::Frequency(frequency),
                None => Law::Closed(ClosedForm { squared: false, value: backbone }),
            },
            rates: [amplitude_rate, phase_rate],
            phase: self.phase,
            drive: self.drive,
            resonance: (self.p, 1),
            detuning: sigma,
            response,
            validity: std::iter::once(cut).chain(notes).collect(),
            derivation,
        };
        Ok(motion.into_solution(self.oscillator))
    }

    /// The steady motions of `P`, `Q` and the waves beside them.
    fn response(
        &self,
        [rate, phase]: [&Expr; 2],
        turning: &[[Expr; 2]; 2],
        bend: &Expr,
    ) -> Result<Response, ExprError> {
        let p = Expr::from(i64::from(self.p));
        let angle = Expr::divide(&(&self.drive.angle() - &Expr::from(self.phase)), &p)?.expand()?;
        let mut response = Response {
            motion: Expr::from(self.a) * angle.cos()?,
            relation: None,
            branches: None,
            peak: None,
            folds: vec![],
            jumps: None,
            closed: None,
            plane: None,
        };
        let polynomial = |expression: &Expr| expression.to_polynomial(&mut |_| None).ok().flatten();
        let polynomials =
            |parts: &[Expr; 2]| Some([polynomial(&parts[0])?, polynomial(&parts[1])?]);
        let whole = || {
            let still = [polynomial(rate)?, polynomial(phase)?];
            Some((still, [polynomials(&turning[0])?, polynomials(&turning[1])?]))
        };
        if let Some(([rate, phase], waves)) = whole() {
            let found = FrequencyResponse::from_rates([&rate, &phase], &waves, self.sigma, self.a);
            response.relation = found.relation;
            response.branches = found.branches;
            response.peak = found.peak;
            response.folds = found.folds;
            response.jumps = found.jumps;
            return Ok(response);
        }
        // If both rates contain the same wave, only its size matters.
        let [[rate_cos, rate_sin], [phase_cos, phase_sin]] = turning;
        let one_wave = phase_sin == rate_cos && *phase_cos == -rate_sin
            || *phase_sin == -rate_cos && phase_cos == rate_sin;
        if one_wave {
            let square = |of: &Expr| of * of;
            let drive = square(rate_cos) + square(rate_sin);
            let over = Expr::divide(&p, &Expr::from(self.a))?;
            response.closed = Some(ClosedRelation {
                relation: square(rate) + square(phase) - &drive,
                centre: (bend * &over).expand()?,
                width_squared: (drive - square(rate)) * square(&over),
            });
        }
        Ok(response)
    }

    /// The derivation of the slow equations, line by line.
    fn derivation(
        &self,
        [amplitude_rate, phase_rate]: [&Expr; 2],
        response: &Response,
    ) -> Result<Vec<DerivationLine>, ExprError> {
        let letters = DerivationLetters::avoiding(&self.oscillator.names());
        let mut lines =
            self.projected.derivation_lines(self.oscillator, &Expr::from(self.a), &letters)?;
        let theta = Expr::from(self.oscillator.phase());
        let turned = &(Expr::from(i64::from(self.p)) * theta) + &Expr::from(self.phase);
        lines.push(
            DerivationLine::equation(self.drive.angle(), turned).because("the drive turns with"),
        );
        lines.push(
            DerivationLine::equation(self.a.derivative(), amplitude_rate.clone())
                .because("what sin(θ) asks for, with the drive"),
        );
        lines.push(
            DerivationLine::equation(self.phase.derivative(), phase_rate.clone())
                .because("what cos(θ) asks for"),
        );
        let closed = response.closed.as_ref().map(|closed| closed.relation.clone());
        if let Some(relation) = response.relation.as_ref().map(Expr::from).or(closed) {
            let steady = "steady where both vanish; cos^2 + sin^2 = 1 eliminates the phase";
            lines.push(
                DerivationLine::equal([
                    DerivationFormula::from(Expr::zero()),
                    DerivationFormula::from(relation),
                ])
                .because(steady),
            );
        }
        Ok(lines)
    }

    fn notes(&self) -> Vec<Note> {
        let letters = self.small.letters();
        let written = |driven: &&Driven| !letters.iter().any(|&name| driven.factor.contains(name));
        let factors = self.drive.terms.iter().filter(written).map(|driven| {
            match driven.factor.has_leading_minus() {
                true => -&driven.factor,
                false => driven.factor.clone(),
            }
        });
        let forces =
            self.drive.terms.iter().any(|driven| driven.is_force(self.oscillator.coordinate));
        let driven = Note::Driven {
            resonance: (self.p, 1),
            parametric: !forces,
            small: std::iter::once(Expr::from(self.sigma)).chain(factors).collect(),
            power: 1,
            nearest: Some((self.p, 1)),
        };
        let root = self.projected.root.clone().map(Note::Positive);
        std::iter::once(driven).chain(root).collect()
    }

    /// The least force that moves what dry friction holds: `S > -P` at the amplitude zero.
    fn least_force(
        &self,
        rate: &Expr,
        [by_cos, by_sin]: &[Expr; 2],
    ) -> Result<Option<Note>, ExprError> {
        let Ok(held) = rate.substitute(self.a, &Expr::zero()).and_then(|held| held.expand()) else {
            return Ok(None);
        };
        if !held.has_leading_minus() || held.terms().len() != 1 {
            return Ok(None);
        }
        let twice = Expr::from(2) * &self.projected.omega0;
        let squares = (by_cos * by_cos + by_sin * by_sin).expand()?;
        let size =
            squares.to_polynomial(&mut |_| None)?.and_then(|squares| squares.single_term_root());
        let free = |size: &Polynomial| {
            !size.symbols().contains(&self.a) && *size != Polynomial::constant(Rational::zero())
        };
        Ok(match size.filter(free) {
            Some(size) => Some(Note::LeastForce {
                force: (&Expr::from(&size) * &twice).expand()?,
                least: (-&held * &twice).expand()?,
            }),
            None => None,
        })
    }
}

//! Drives of a motion: waves in time whose frequencies are multiples of one, alone or beside powers
//! of the coordinate and its velocity.
//!
//! ```text
//! F cos(Omega t + phi), F sin(Omega t), h x cos(2 Omega t), and sums of them
//! ```
//!
//! Time is measured from the phase of the first wave; the others have a phase relative to it,
//! `cos(m theta + delta) = cos(delta) cos(m theta) - sin(delta) sin(m theta)`. A phase that
//! contains the coordinate, as in the travelling wave `cos(Omega t - k x)`, is separated likewise
//! and becomes a factor of two waves.

use num_integer::Integer as _;
use num_traits::{Signed as _, ToPrimitive as _, Zero as _};

use super::resonance::{RESONANCES, is_ratio};
use super::{Reason, Refusal};
use crate::exact::rational::Integer;
use crate::exact::{Polynomial, Rational};
use crate::expr::{Expr, ExprError, Function, Node};
use crate::oscillator::{Oscillator, Parts};
use crate::series::taylor::taylor;
use crate::solution::{Definition, Method};
use crate::symbol::{Symbol, fresh_stem};

/// The waves of a drive.
pub(super) struct Drive {
    /// The driving frequency of which those of all waves are multiples.
    pub(super) frequency: Expr,
    /// The phase of that frequency at which the first wave begins.
    pub(super) phase: Expr,
    /// The driven terms.
    pub(super) terms: Vec<Driven>,
    /// Sines and cosines of phases that are not fractions.
    pub(super) definitions: Vec<Definition>,
}

/// A term of the force that a wave multiplies.
pub(super) struct Driven {
    /// The factor of the wave, without the time.
    pub(super) factor: Expr,
    /// The multiple of the driving frequency.
    pub(super) multiple: u32,
    pub(super) quadrature: Quadrature,
    /// The difference of the degree to that of the first term, for a term of a
    /// [series](Drive::in_small_motions).
    pub(super) above: u32,
    /// The whole term, for messages.
    pub(super) term: Expr,
}

/// The quadrature of a drive: cosine or sine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quadrature {
    /// `cos`.
    Cosine,
    /// `sin`.
    Sine,
}

impl Quadrature {
    /// The other quadrature, which a phase difference mixes in, and its sign.
    fn quarter_later(self) -> (Self, Expr) {
        match self {
            Self::Cosine => (Self::Sine, -Expr::one()),
            Self::Sine => (Self::Cosine, Expr::one()),
        }
    }
}

impl Driven {
    /// Whether it is a force, free of the motion.
    pub(super) fn is_force(&self, coordinate: Symbol) -> bool {
        let own = [coordinate, coordinate.derivative()];
        own.iter().all(|&name| !self.factor.contains(name))
    }

    /// The terms of the series of the factor about rest; `None` if it is a polynomial already, or
    /// has none.
    fn in_small_motions(&self, coordinate: Symbol, degree: u32) -> Option<Vec<Self>> {
        if self.factor.to_polynomial(&mut |_| None).ok()?.is_some() {
            return None;
        }
        let rest = [coordinate, coordinate.derivative()].map(|name| (name, Rational::zero()));
        let parts = taylor(&self.factor, &rest, degree).ok()?;
        let first = parts.iter().position(|part| !part.is_zero())?;
        let mut terms = vec![];
        for (power, part) in parts.iter().enumerate().skip(first) {
            let polynomial = part.to_polynomial(&mut |_| None).ok()??;
            for (monomial, number) in polynomial.terms() {
                terms.push(Self {
                    factor: Expr::from(&Polynomial::term(monomial.clone(), number.clone())),
                    multiple: self.multiple,
                    quadrature: self.quadrature,
                    above: u32::try_from(power - first).ok()?,
                    term: self.term.clone(),
                });
            }
        }
        Some(terms)
    }
}

impl Drive {
    /// The driving frequency, and the terms that its multiples drive.
    ///
    /// # Errors
    /// A term that is not a wave of it, by name.
    pub(super) fn from_parts(
        parts: &Parts,
        oscillator: &Oscillator,
        method: Method,
    ) -> Result<Self, Refusal> {
        /// Largest multiple of a common frequency that a wave may have.
        const HIGHEST_MULTIPLE: u32 = 12;
        let taken = oscillator.names();
        let mut drive = Self {
            frequency: Expr::one(),
            phase: Expr::zero(),
            terms: vec![],
            definitions: vec![],
        };
        let terms = parts.forcing.terms();
        let waves: Vec<HarmonicExcitation> = terms
            .iter()
            .map(|term| HarmonicExcitation::new(term, method))
            .collect::<Result<_, _>>()?;
        let Some(first) = waves.first() else {
            return Ok(drive);
        };
        let mut multiples: Vec<Rational> = vec![];
        for (wave, term) in waves.iter().zip(terms) {
            let multiple = Expr::divide(&wave.rate, &first.rate)?.expand()?;
            match multiple.as_number().filter(|number| number.is_positive()) {
                Some(multiple) => multiples.push(multiple.clone()),
                None => {
                    return Err(Reason::SecondDrive.to(method).about(term));
                }
            }
        }
        // The largest frequency of which all are multiples.
        let below = multiples.iter().fold(1.into(), |common: Integer, own| common.lcm(own.denom()));
        let whole: Vec<Integer> = multiples
            .iter()
            .map(|own| (own * Rational::from_integer(below.clone())).to_integer())
            .collect();
        let common = whole.iter().fold(0.into(), |common: Integer, own| common.gcd(own));
        let unit = Rational::new(common.clone(), below);
        drive.frequency = (&Expr::number(unit) * &first.rate).expand()?;
        let multiple_of =
            |number: &Integer| (number / &common).to_u32().filter(|own| *own <= HIGHEST_MULTIPLE);
        for ((wave, number), term) in waves.into_iter().zip(&whole).zip(terms) {
            let Some(multiple) = multiple_of(number) else {
                return Err(Reason::SecondDrive.to(method).about(term));
            };
            if drive.terms.is_empty() {
                let phase = wave.still_phase(oscillator.coordinate);
                drive.phase = Expr::divide(&phase, &Expr::from(i64::from(multiple)))?.expand()?;
            }
            for wave in wave.apart_from(oscillator.coordinate)? {
                drive.add(wave, multiple, term, &taken)?;
            }
        }
        Ok(drive)
    }

    /// The ratio to the linear frequency of the wave that is in resonance, at a ratio of the
    /// driving frequency; `None` if only sums and differences of several frequencies are.
    pub(super) fn nearest(&self, (p, q): (u32, u32)) -> Option<(u32, u32)> {
        if self.terms.iter().all(|driven| driven.multiple == 1) {
            return Some((p, q));
        }
        let ratios: Vec<(u32, u32)> = self
            .terms
            .iter()
            .map(|driven| {
                let above = p * driven.multiple;
                let common = above.gcd(&q);
                (above / common, q / common)
            })
            .collect();
        RESONANCES.into_iter().find(|known| ratios.contains(known))
    }

    /// The resonances at which one of the waves has one of the [known ratios](RESONANCES) to the
    /// linear frequency, or a sum or difference of two frequencies or of one and twice another is
    /// that, as ratios of the driving frequency, the likeliest first.
    pub(super) fn resonances(&self) -> Vec<(u32, u32)> {
        let mut multiples: Vec<u32> = self.terms.iter().map(|driven| driven.multiple).collect();
        multiples.sort_unstable();
        multiples.dedup();
        let ratios = RESONANCES.into_iter().flat_map(|(p, q)| {
            multiples.iter().map(move |multiple| {
                let below = q * multiple;
                let common = p.gcd(&below);
                (p / common, below / common)
            })
        });
        let pairs =
            || multiples.iter().flat_map(|one| multiples.iter().map(move |other| (*one, *other)));
        let combined = pairs().filter(|(one, other)| one < other).flat_map(|(one, other)| {
            let twice =
                [2 * one + other, (2 * one).abs_diff(other), one + 2 * other, 2 * other - one];
            [one + other, other - one].into_iter().chain(twice)
        });
        let mut found = vec![];
        for ratio in ratios.chain(combined.map(|sum| (1, sum))) {
            if is_ratio(ratio) && !found.contains(&ratio) {
                found.push(ratio);
            }
        }
        found
    }

    /// Returns the drive with functions of the motion replaced by their series about rest, up to a
    /// degree: `h sin(x) cos(Omega t)` of a shaken pendulum. A function without such a series stays
    /// as it is.
    pub(super) fn in_small_motions(mut self, coordinate: Symbol, degree: u32) -> Self {
        self.terms = self
            .terms
            .into_iter()
            .flat_map(|driven| match driven.in_small_motions(coordinate, degree) {
                Some(series) => series,
                None => vec![driven],
            })
            .collect();
        self
    }

    /// The driving frequency of one of the waves.
    pub(super) fn frequency_of(&self, driven: &Driven) -> Expr {
        &Expr::from(i64::from(driven.multiple)) * &self.frequency
    }

    /// The argument of the waves: `Omega t + phi`.
    pub(super) fn angle(&self) -> Expr {
        &(&self.frequency * &Expr::symbol("t")) + &self.phase
    }

    fn add(
        &mut self,
        wave: HarmonicExcitation,
        multiple: u32,
        term: &Expr,
        taken: &[Symbol],
    ) -> Result<(), ExprError> {
        let mut push = |factor: Expr, quadrature| {
            if !factor.is_zero() {
                self.terms.push(Driven {
                    factor,
                    multiple,
                    quadrature,
                    above: 0,
                    term: term.clone(),
                });
            }
        };
        let apart = (&wave.phase - &(&Expr::from(i64::from(multiple)) * &self.phase)).expand()?;
        if apart.is_zero() {
            push(wave.factor, wave.quadrature);
            return Ok(());
        }
        let (other, sign) = wave.quadrature.quarter_later();
        let own = named(apart.cos()?, "C", &mut self.definitions, taken);
        let across = named(apart.sin()?, "S", &mut self.definitions, taken);
        push(&wave.factor * &own, wave.quadrature);
        push(&(&sign * &wave.factor) * &across, other);
        Ok(())
    }
}

/// A constant, replaced by a name if it is not a number.
fn named(value: Expr, letter: &str, definitions: &mut Vec<Definition>, taken: &[Symbol]) -> Expr {
    if value.as_number().is_some() {
        return value;
    }
    if let Some(known) = definitions.iter().find(|known| known.meaning == value) {
        return Expr::from(known.symbol);
    }
    let stem = fresh_stem(letter, taken);
    let symbol = Symbol::new(&format!("{stem}{}", definitions.len() / 2 + 1));
    definitions.push(Definition { symbol, meaning: value });
    Expr::from(symbol)
}

/// One term: `factor cos(rate t + phase)` or the sine of that, the rate without a minus.
#[derive(Clone, Debug)]
pub struct HarmonicExcitation {
    /// The factor of the wave.
    pub factor: Expr,
    /// The rate at which its phase turns, without a minus.
    pub rate: Expr,
    /// Its phase at `t = 0`.
    pub phase: Expr,
    /// Whether it is a cosine or a sine.
    pub quadrature: Quadrature,
}

impl HarmonicExcitation {
    /// # Errors
    /// A term that is not a single wave, by name.
    pub(super) fn new(term: &Expr, method: Method) -> Result<Self, Refusal> {
        Self::of_term(term)?.ok_or_else(|| Reason::NoWave.to(method).about(term))
    }

    /// The wave in a term; `None` of a term that is not a single wave.
    ///
    /// # Errors
    /// A step of algebra that fails.
    pub fn of_term(term: &Expr) -> Result<Option<Self>, ExprError> {
        let t = Symbol::new("t");
        let (number, factors) = term.factors();
        let (moving, still): (Vec<&Expr>, Vec<&Expr>) =
            factors.iter().partition(|factor| factor.contains(t));
        let [wave] = moving.as_slice() else {
            return Ok(None);
        };
        let (quadrature, argument) = match wave.node() {
            Node::Function(Function::Cos, arguments) => (Quadrature::Cosine, &arguments[0]),
            Node::Function(Function::Sin, arguments) => (Quadrature::Sine, &arguments[0]),
            _ => return Ok(None),
        };
        let argument = argument.expand()?;
        let (turning, rest): (Vec<Expr>, Vec<Expr>) =
            argument.terms().iter().cloned().partition(|term| term.contains(t));
        let (mut rate, mut phase) =
            (Expr::divide(&Expr::sum(turning), &Expr::from(t))?.expand()?, Expr::sum(rest));
        let moves =
            |part: &Expr| part.contains(t) || part.symbols().iter().any(|name| name.primes() > 0);
        if moves(&rate) || moves(&phase) {
            return Ok(None);
        }
        let mut factor =
            Expr::product(std::iter::once(Expr::number(number)).chain(still.into_iter().cloned()));
        if rate.has_leading_minus() {
            (rate, phase) = (-&rate, -&phase);
            if quadrature == Quadrature::Sine {
                factor = -&factor;
            }
        }
        Ok(Some(Self { factor, rate, phase, quadrature }))
    }

    /// The part of the phase that does not contain the coordinate.
    fn still_phase(&self, coordinate: Symbol) -> Expr {
        let terms = self.phase.terms().iter().cloned();
        Expr::sum(terms.filter(|term| !term.contains(coordinate)))
    }

    /// The wave with what the coordinate adds to its phase as a factor:
    /// `cos(theta + g) = cos(g) cos(theta) - sin(g) sin(theta)`,
    /// `sin(theta + g) = cos(g) sin(theta) + sin(g) cos(theta)`.
    fn apart_from(self, coordinate: Symbol) -> Result<Vec<Self>, ExprError> {
        if !self.phase.contains(coordinate) {
            return Ok(vec![self]);
        }
        let phase = self.still_phase(coordinate);
        let moving = (&self.phase - &phase).expand()?;
        let (other, sign) = self.quadrature.quarter_later();
        let with = |factor: Expr, quadrature: Quadrature| Self {
            factor,
            rate: self.rate.clone(),
            phase: phase.clone(),
            quadrature,
        };
        Ok(vec![
            with(&self.factor * &moving.cos()?, self.quadrature),
            with(&(&sign * &self.factor) * &moving.sin()?, other),
        ])
    }
}

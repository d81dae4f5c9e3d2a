//! Elimination of secular terms: the step every perturbation method of this crate shares.
//!
//! Reference: A. H. Nayfeh, *Perturbation Methods*, Wiley 1973, section 3.1 (Lindstedt-Poincare);
//! C. M. Andersen and J. F. Geer, *Power series expansions for the frequency and period of the
//! limit cycle of the van der Pol equation*, SIAM J. Appl. Math. 42 (1982) 678-693 (limit cycles,
//! order by order).
//!
//! With `tau = omega t`, `x = y_0 + delta y_1 + ...`, `omega^2 = 1 + delta W_1 + ...`,
//! `y_0 = cos tau`:
//!
//! ```text
//! y_n'' + y_n = r_n + W_n cos tau,     r_n = - sum_j c_j [y^p (omega y')^q]_(n - a_j) - sum_(0<i<n) W_i y_(n-i)''
//! W_n = - (cos tau part of r_n)        no secular cosine
//! B_(n-1) = - (sin tau part) / J       limit cycles only: no secular sine, J its derivative in the amplitude
//! omega_n = (W_n - sum_(0<i<n) omega_i omega_(n-i)) / 2
//! ```

mod denominators;
mod fixed_width;
mod lower_set;
mod modular;
mod orders;
mod plan;
mod reconstruct;
mod sine;
mod symbolic;

pub(super) use denominators::Factored;
pub use reconstruct::ExpansionScope;

use std::borrow::Cow;
use std::collections::HashMap;

use num_integer::Integer as _;

use crate::exact::ring::NotInvertible;
use crate::exact::{Integers, Polynomials, Ring};
use crate::interrupt::Supervision;
use crate::series::convolution::{Convolutions, SeriesNode};
use crate::series::fourier::{FourierSeries, sum_of_products};
use crate::solution::AmplitudeConvention;

/// One term `delta^order * coefficient * y^position * y'^velocity` of the force beside the linear
/// `y`.
#[derive(Clone, Debug)]
pub struct ForceTerm<R: Ring> {
    /// Power of the small parameter, at least one.
    pub order: usize,
    /// Power of `y`.
    pub position: u32,
    /// Power of `y'` (derivative in the time of the linear frequency, or in that of the frequency
    /// itself if the detuning multiplies `y`).
    pub velocity: u32,
    /// A constant series.
    pub coefficient: FourierSeries<R>,
}

/// Whether the amplitude is free (conservative) or determined by the equation (self-excited).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AmplitudeKind {
    /// A family of periodic motions, one for every amplitude.
    Free,
    /// An isolated limit cycle: `y = cos tau` already has the amplitude at which the first order
    /// has no secular sine.
    Determined,
}

/// The series that the corrections `W_i` of the frequency multiply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detuning {
    /// `omega^2 = 1 + delta W_1 + ...` before `y''`: Lindstedt and Poincare.
    Acceleration,
    /// `1 = omega^2 (1 - delta W_1 - ...)` before `y`, all in units of omega^2: homotopy
    /// perturbation.
    Displacement,
}

/// The choices that tell one method from another.
#[derive(Clone, Copy, Debug)]
pub struct Scheme {
    /// The condition that fixes the homogeneous solutions: `y(0) = 1` and `y'(0) = 0`, or the first
    /// harmonic of `y` is `cos tau` exactly.
    pub normalisation: AmplitudeConvention,
    /// Free or determined.
    pub amplitude: AmplitudeKind,
    /// The term of the equation in which the frequency is expanded.
    pub detuning: Detuning,
}

/// The result, order by order.
#[derive(Clone, Debug)]
pub struct SecularExpansion<R: Ring> {
    /// `W_n`: omega^2 in powers of the small parameter, constant series; `W_0 = 1`.
    pub frequency_squared: Vec<FourierSeries<R>>,
    /// omega in powers of the small parameter, constant series.
    pub frequency: Vec<FourierSeries<R>>,
    /// `y_n(tau)`.
    pub displacement: Vec<FourierSeries<R>>,
    /// The condition that fixed the amplitude of each `y_n` of a limit cycle, from order one on;
    /// empty if the amplitude is free.
    pub amplitudes: Vec<SecularSine<R>>,
}

/// The condition `sine + slope B_n = 0` of order `n + 1`, which fixes the amplitude of `y_n`.
#[derive(Clone, Debug)]
pub struct SecularSine<R: Ring> {
    /// The secular sine with `B_n = 0`.
    pub sine: FourierSeries<R>,
    /// Its derivative in `B_n`.
    pub slope: FourierSeries<R>,
    /// `B_n`.
    pub amplitude: FourierSeries<R>,
}

/// The reason why no periodic expansion exists.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SecularError {
    /// A sine at the natural frequency that neither frequency nor amplitude can remove: energy is
    /// lost or gained. One that [may be zero](Ring::may_be_zero) is taken to be zero.
    #[error("a secular sine remains at order {order}: the motion gains or loses energy")]
    Growth {
        /// The order at which it appears.
        order: usize,
    },
    /// The amplitude equation at this order is degenerate, or its solution would divide by a sum of
    /// symbols, or by what may be zero in the ring: an interval around zero, a multiple of the
    /// prime.
    #[error("the amplitude cannot be determined at order {order}")]
    Degenerate {
        /// The order at which it fails.
        order: usize,
    },
    /// The ring of the coefficients has no inverse of a divisor of this order: another prime is
    /// needed.
    #[error("{indivisible}, which order {order} needs")]
    Indivisible {
        /// The order at which it fails.
        order: usize,
        /// The divisor and the ring.
        indivisible: NotInvertible,
    },
    /// The expansion would take far too long.
    #[error(
        "the power {degree} in the equation gives {harmonics} harmonics at this order, with coefficients of hundreds of digits"
    )]
    TooManyHarmonics {
        /// The highest power of position and velocity together.
        degree: u32,
        /// The highest harmonic at the highest order.
        harmonics: usize,
    },
}

/// An error if a high power makes an expansion to this order far too long; `terms` are the order of
/// each term of the force and its power of position and velocity together.
///
/// # Errors
/// [`SecularError::TooManyHarmonics`].
pub fn bounded(
    terms: impl Iterator<Item = (usize, u32)>,
    highest: usize,
) -> Result<(), SecularError> {
    /// Lower powers are not checked: for them any order may be asked for.
    const HIGH_POWER: u32 = 30;
    const MOST_WORK: f64 = 1e9;
    // Number of harmonics per order: the power n + 1 of a sine at order n adds one harmonic per
    // order.
    let rate = |(order, power): (usize, u32)| power / u32::try_from(order.max(1)).unwrap_or(1);
    let degree = terms.map(rate).max().unwrap_or(0);
    if degree <= HIGH_POWER {
        return Ok(());
    }
    let harmonics = highest.saturating_mul(degree.saturating_sub(1) as usize).saturating_add(1);
    // Products of series of this many harmonics, whose coefficients are as long as binomials of
    // that size.
    let (orders, length) = (highest as f64, harmonics as f64);
    let work = (orders * length).powi(2) * f64::from(degree).log2() * (length / 32.0).max(1.0);
    match work > MOST_WORK {
        true => Err(SecularError::TooManyHarmonics { degree, harmonics }),
        false => Ok(()),
    }
}

/// Expands frequency and displacement to `highest`, inclusive, with coefficients in `ring`.
///
/// Cost: with `H` harmonics at the highest order, every product of the equation takes
/// `O(highest^2 H^2)` coefficient products in all.
///
/// # Errors
/// See [`SecularError`].
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::exact::Doubles;
/// use lindstedt::method::secular::{AmplitudeKind, Detuning, ForceTerm, Scheme, expand};
/// use lindstedt::{series::FourierSeries, solution::AmplitudeConvention};
///
/// // x'' + x + delta x^3 = 0
/// let cubic = ForceTerm { order: 1, position: 3, velocity: 0, coefficient: FourierSeries::constant(Doubles, 1.0) };
/// let scheme = Scheme {
///     normalisation: AmplitudeConvention::Initial,
///     amplitude: AmplitudeKind::Free,
///     detuning: Detuning::Acceleration,
/// };
/// let found = expand(&Doubles, &[cubic], 1, &scheme)?;
/// assert_eq!(found.frequency_squared[1].mean().0, 0.75); // omega^2 = 1 + 3 delta/4
/// # Ok::<(), lindstedt::method::secular::SecularError>(())
/// ```
pub fn expand<R: Ring>(
    ring: &R,
    force: &[ForceTerm<R>],
    highest: usize,
    scheme: &Scheme,
) -> Result<SecularExpansion<R>, SecularError> {
    expand_from_root(ring, force, highest, scheme, None)
}

/// Expands like [`expand`] over the whole numbers, with the same result, but modulo many primes if
/// the numbers are long; on request only the [frequency](ExpansionScope::Frequency).
///
/// # Errors
/// See [`SecularError`].
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::exact::{Integers, Integer};
/// use lindstedt::method::secular::{AmplitudeKind, Detuning, ExpansionScope, ForceTerm, Scheme, expand_numbers};
/// use lindstedt::{series::FourierSeries, solution::AmplitudeConvention};
///
/// // Duffing: y'' + y + delta y^3 = 0
/// let cube = ForceTerm { order: 1, position: 3, velocity: 0, coefficient: FourierSeries::integer(Integers, 1) };
/// let scheme = Scheme {
///     normalisation: AmplitudeConvention::Initial,
///     amplitude: AmplitudeKind::Free,
///     detuning: Detuning::Acceleration,
/// };
/// let found = expand_numbers(&[cube], 40, &scheme, ExpansionScope::Frequency)?;
/// assert_eq!(found.frequency_squared[1].mean(), (Integer::from(3), &Integer::from(4)));
/// assert!(found.frequency_squared[40].mean().1.bits() > 150);
/// # Ok::<(), lindstedt::method::secular::SecularError>(())
/// ```
pub fn expand_numbers(
    force: &[ForceTerm<Integers>],
    highest: usize,
    scheme: &Scheme,
    extent: ExpansionScope,
) -> Result<SecularExpansion<Integers>, SecularError> {
    expand_numbers_supervised(force, highest, scheme, extent, Supervision::default())
}

/// Expands like [`expand_numbers`], to the order reached if it is interrupted.
///
/// # Errors
/// See [`SecularError`].
pub(crate) fn expand_numbers_supervised(
    force: &[ForceTerm<Integers>],
    highest: usize,
    scheme: &Scheme,
    extent: ExpansionScope,
    supervision: Supervision,
) -> Result<SecularExpansion<Integers>, SecularError> {
    bounded(force.iter().map(|term| (term.order, term.position + term.velocity)), highest)?;
    // If all terms have orders that are multiples of one number, as for an amplitude that enters
    // squared, so has the solution.
    let step = force.iter().fold(0, |common, term| common.gcd(&term.order)).max(1);
    let compress =
        |term: &ForceTerm<Integers>| ForceTerm { order: term.order / step, ..term.clone() };
    let compressed: Cow<'_, [ForceTerm<Integers>]> = match step {
        1 => force.into(),
        _ => force.iter().map(compress).collect(),
    };
    let orders = highest / step;
    let by_words = reconstruct::expand(&compressed, orders, scheme, extent, supervision);
    let mut expansion = match by_words {
        Some(expansion) => expansion,
        None => expand_supervised(&Integers, &compressed, orders, scheme, None, supervision)?,
    };
    if extent == ExpansionScope::Frequency {
        expansion.forget_motion();
    }
    Ok(match step {
        1 => expansion,
        _ => match expansion.frequency.len() {
            reached if reached <= orders => expansion.spread(step, (reached - 1) * step),
            _ => expansion.spread(step, highest),
        },
    })
}

/// Expands like [`expand`] over polynomials with whole coefficients, with the same result, but by
/// interpolation from many values of the symbols if these have many products.
///
/// # Errors
/// See [`SecularError`].
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::exact::{Integers, Polynomial, Polynomials};
/// use lindstedt::method::secular::{AmplitudeKind, Detuning, ExpansionScope, ForceTerm, Scheme, expand_polynomials};
/// use lindstedt::{Symbol, series::FourierSeries, solution::AmplitudeConvention};
///
/// // y'' + y + delta (a y^2 + b y^3) = 0
/// let term = |position, name| {
///     let coefficient = Polynomial::symbol(Symbol::new(name));
///     ForceTerm { order: 1, position, velocity: 0, coefficient: FourierSeries::constant(Polynomials(Integers), coefficient) }
/// };
/// let scheme = Scheme {
///     normalisation: AmplitudeConvention::FirstHarmonic,
///     amplitude: AmplitudeKind::Free,
///     detuning: Detuning::Acceleration,
/// };
/// let found = expand_polynomials(&[term(2, "a"), term(3, "b")], 6, &scheme, ExpansionScope::Frequency)?;
/// let (numerator, denominator) = found.frequency_squared[2].mean();
/// // -5/6 a^2 + 3/128 b^2
/// assert_eq!((numerator.terms().len(), denominator.to_string().as_str()), (2, "384"));
/// # Ok::<(), lindstedt::method::secular::SecularError>(())
/// ```
pub fn expand_polynomials(
    force: &[ForceTerm<Polynomials<Integers>>],
    highest: usize,
    scheme: &Scheme,
    extent: ExpansionScope,
) -> Result<SecularExpansion<Polynomials<Integers>>, SecularError> {
    expand_polynomials_supervised(force, highest, scheme, extent, Supervision::default())
}

/// Expands like [`expand_polynomials`], to the order reached if it is interrupted.
///
/// # Errors
/// See [`SecularError`].
pub(crate) fn expand_polynomials_supervised(
    force: &[ForceTerm<Polynomials<Integers>>],
    highest: usize,
    scheme: &Scheme,
    extent: ExpansionScope,
    supervision: Supervision,
) -> Result<SecularExpansion<Polynomials<Integers>>, SecularError> {
    /// Number of terms below which there are few products.
    const MANY: usize = 2;
    bounded(force.iter().map(|term| (term.order, term.position + term.velocity)), highest)?;
    if highest >= MANY
        && let Some(expansion) = symbolic::expand(force, highest, scheme, extent, supervision)
    {
        return Ok(expansion);
    }
    let mut expansion =
        expand_supervised(&Polynomials(Integers), force, highest, scheme, None, supervision)?;
    if extent == ExpansionScope::Frequency {
        expansion.forget_motion();
    }
    Ok(expansion)
}

impl<R: Ring> SecularExpansion<R> {
    /// Empties every list but those of the frequency.
    pub fn forget_motion(&mut self) {
        self.displacement.clear();
        self.amplitudes.clear();
    }
}

impl SecularExpansion<Integers> {
    /// Returns the expansion with order n moved to order `step * n`, up to `highest`.
    fn spread(self, step: usize, highest: usize) -> Self {
        let zero = || FourierSeries::zero(Integers);
        let spread = |series: Vec<FourierSeries<Integers>>| {
            let mut spread: Vec<_> =
                if series.is_empty() { vec![] } else { vec![zero(); highest + 1] };
            for (order, own) in series.into_iter().enumerate() {
                spread[order * step] = own;
            }
            spread
        };
        // If the amplitude is determined, the first order is damping, and nothing is spread.
        Self {
            frequency_squared: spread(self.frequency_squared),
            frequency: spread(self.frequency),
            displacement: spread(self.displacement),
            amplitudes: self.amplitudes,
        }
    }
}

/// Expands like [`expand`] about a limit cycle whose amplitude is a symbol for a root:
/// `inverse_slope` is `1/J`, a constant series. Secular sines vanish by the equation of that root,
/// which the ring does not contain, so they are not checked.
///
/// # Errors
/// See [`SecularError`].
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::exact::Doubles;
/// use lindstedt::method::secular::{AmplitudeKind, Detuning, ForceTerm, Scheme, expand_from_root};
/// use lindstedt::{series::FourierSeries, solution::AmplitudeConvention};
///
/// // The cycle of van der Pol, x = 2 y: y'' + y - delta y' + 4 delta y^2 y' = 0
/// let number = |value| FourierSeries::constant(Doubles, value);
/// let term = |position, coefficient| ForceTerm { order: 1, position, velocity: 1, coefficient: number(coefficient) };
/// let scheme = Scheme {
///     normalisation: AmplitudeConvention::FirstHarmonic,
///     amplitude: AmplitudeKind::Determined,
///     detuning: Detuning::Acceleration,
/// };
/// // Along a*cos(tau) the secular sine is a^3 - a: its slope at a = 1 is 2.
/// let found = expand_from_root(&Doubles, &[term(0, -1.0), term(2, 4.0)], 2, &scheme, Some(number(0.5)))?;
/// assert!((found.frequency_squared[2].mean().0 + 0.125).abs() < 1e-15); // omega^2 = 1 - delta^2/8
/// # Ok::<(), lindstedt::method::secular::SecularError>(())
/// ```
pub fn expand_from_root<R: Ring>(
    ring: &R,
    force: &[ForceTerm<R>],
    highest: usize,
    scheme: &Scheme,
    inverse_slope: Option<FourierSeries<R>>,
) -> Result<SecularExpansion<R>, SecularError> {
    expand_supervised(ring, force, highest, scheme, inverse_slope, Supervision::default())
}

/// Expands like [`expand_from_root`], to the order reached if it is interrupted, but at least to
/// the first.
///
/// # Errors
/// See [`SecularError`].
pub(crate) fn expand_supervised<R: Ring>(
    ring: &R,
    force: &[ForceTerm<R>],
    highest: usize,
    scheme: &Scheme,
    inverse_slope: Option<FourierSeries<R>>,
    supervision: Supervision,
) -> Result<SecularExpansion<R>, SecularError> {
    let of_amplitude = usize::from(scheme.amplitude == AmplitudeKind::Determined);
    let powers = force.iter().map(|term| (term.order, term.position + term.velocity));
    bounded(powers, highest.saturating_add(of_amplitude))?;
    let mut order_by_order = OrderByOrder::new(ring, force, highest, *scheme, inverse_slope);
    supervision.progress.begin(highest);
    let mut reached = 0;
    while reached < highest && !(reached > 0 && supervision.interrupt.is_requested()) {
        reached += 1;
        order_by_order.solve_order(reached)?;
        supervision.progress.advance();
    }
    order_by_order.fix_last_amplitude(reached)?;
    Ok(order_by_order.result)
}

struct OrderByOrder<'a, R: Ring> {
    ring: &'a R,
    force: &'a [ForceTerm<R>],
    products: Vec<Option<SeriesNode>>,
    convolutions: Convolutions<R>,
    position: SeriesNode,
    velocity: SeriesNode,
    scheme: Scheme,
    /// `1/J`, where it was given.
    inverse_slope: Option<FourierSeries<R>>,
    /// Derivatives of the series by the amplitude of `y_0`.
    variations: Vec<FourierSeries<R>>,
    /// `y_n''` or `-y_n`: what the corrections of the frequency multiply.
    detuned: Vec<FourierSeries<R>>,
    result: SecularExpansion<R>,
}

impl<'a, R: Ring> OrderByOrder<'a, R> {
    fn new(
        ring: &'a R,
        force: &'a [ForceTerm<R>],
        highest: usize,
        scheme: Scheme,
        inverse_slope: Option<FourierSeries<R>>,
    ) -> Self {
        let mut convolutions = Convolutions::new(ring.clone());
        let (position, velocity) = (convolutions.leaf(), convolutions.leaf());
        // The last amplitude of a limit cycle follows from one order more than is kept.
        let last =
            if scheme.amplitude == AmplitudeKind::Determined { highest + 1 } else { highest };
        let mut product_of = |term: &ForceTerm<R>| {
            let powers = [(position, term.position), (velocity, term.velocity)];
            let powers = powers.into_iter().filter(|power| power.1 > 0);
            let nodes: Vec<SeriesNode> =
                powers.map(|(node, exponent)| convolutions.power(node, exponent)).collect();
            let node = nodes.into_iter().reduce(|left, right| convolutions.product(left, right))?;
            if let Some(needed) = last.checked_sub(term.order) {
                convolutions.require(node, needed);
            }
            Some(node)
        };
        let products = force.iter().map(&mut product_of).collect();
        let start = FourierSeries::cos(ring.clone(), 1);
        convolutions.push(position, start.clone());
        convolutions.push(velocity, start.derivative());
        convolutions.advance(0);
        let leaves = HashMap::from([(position, start.clone()), (velocity, start.derivative())]);
        let variations = convolutions.variations(&leaves);
        let result = SecularExpansion {
            frequency_squared: vec![FourierSeries::integer(ring.clone(), 1)],
            frequency: vec![FourierSeries::integer(ring.clone(), 1)],
            displacement: vec![start.clone()],
            amplitudes: vec![],
        };
        // y_0'' and -y_0 are the same.
        let detuned = vec![start.times(-1)];
        Self {
            ring,
            force,
            products,
            convolutions,
            position,
            velocity,
            scheme,
            inverse_slope,
            variations,
            detuned,
            result,
        }
    }

    fn solve_order(&mut self, order: usize) -> Result<(), SecularError> {
        let mut right_side = divided(order, self.right_side(order))?;
        if self.scheme.amplitude == AmplitudeKind::Determined && order > 1 {
            right_side = self.fix_amplitude(order, right_side)?;
        }
        let (particular, resonance) = right_side.solve_oscillator();
        let particular = divided(order, particular)?;
        if !resonance.sine.may_be_zero() && self.inverse_slope.is_none() {
            return Err(SecularError::Growth { order });
        }
        self.result.frequency_squared.push(resonance.cosine.times(-1));
        self.push_frequency(order)?;
        let displacement = divided(order, self.normalised(particular))?;
        self.push_displacement(order, displacement);
        Ok(())
    }

    /// `r_n` as in the head of this file.
    fn right_side(&self, order: usize) -> FourierSeries<R> {
        let one = FourierSeries::integer(self.ring.clone(), 1);
        let mut terms = Vec::new();
        for (term, product) in self.force.iter().zip(&self.products) {
            let Some(of_product) = order.checked_sub(term.order) else {
                continue;
            };
            match product {
                Some(node) => terms.extend(
                    self.convolutions
                        .order(*node, of_product)
                        .map(|series| (-1, &term.coefficient, series)),
                ),
                None if of_product == 0 => terms.push((-1, &term.coefficient, &one)),
                None => {}
            }
        }
        for lower in 1..order {
            terms.push((-1, &self.result.frequency_squared[lower], &self.detuned[order - lower]));
        }
        sum_of_products(self.ring, &terms)
    }

    /// Chooses the amplitude of `y_(order-1)` so that `right_side` of `order` has no secular sine,
    /// and carries the choice through everything already computed.
    fn fix_amplitude(
        &mut self,
        order: usize,
        right_side: FourierSeries<R>,
    ) -> Result<FourierSeries<R>, SecularError> {
        let mut terms = Vec::new();
        for (term, product) in self.force.iter().zip(&self.products) {
            if let (1, Some(node)) = (term.order, product) {
                terms.push((
                    -1,
                    &term.coefficient,
                    Convolutions::variation_of(&self.variations, *node),
                ));
            }
        }
        if let Some(first) = self.result.frequency_squared.get(1) {
            terms.push((-1, first, &self.detuned[0]));
        }
        let change = sum_of_products(self.ring, &terms);
        let (sine, slope) = (right_side.sine(1), change.sine(1));
        let needed = sine.times(-1);
        let correction = match &self.inverse_slope {
            _ if needed.is_zero() => FourierSeries::zero(self.ring.clone()),
            Some(inverse) => needed.product(inverse),
            None => needed.divided_by_constant(&slope).ok_or(SecularError::Degenerate { order })?,
        };
        let correction = divided(order, correction)?;
        self.result.amplitudes.push(SecularSine { sine, slope, amplitude: correction.clone() });
        self.convolutions.correct(order - 1, &correction, &self.variations);
        let corrected =
            self.result.displacement[order - 1].sum(&correction.product(&self.cos_tau()));
        self.detuned[order - 1] = self.frequency_factor(&corrected);
        self.result.displacement[order - 1] = corrected;
        divided(order, right_side.sum(&correction.product(&change)))
    }

    fn fix_last_amplitude(&mut self, highest: usize) -> Result<(), SecularError> {
        if self.scheme.amplitude == AmplitudeKind::Determined && highest > 0 {
            let right_side = divided(highest + 1, self.right_side(highest + 1))?;
            self.fix_amplitude(highest + 1, right_side)?;
        }
        Ok(())
    }

    fn push_frequency(&mut self, order: usize) -> Result<(), SecularError> {
        let lower = &self.result.frequency;
        let products: Vec<_> = (1..order).map(|i| (-1, &lower[i], &lower[order - i])).collect();
        let squares = sum_of_products(self.ring, &products);
        let frequency = self.result.frequency_squared[order].sum(&squares).divided_by(2);
        self.result.frequency.push(divided(order, frequency)?);
        Ok(())
    }

    /// `cos tau`.
    fn cos_tau(&self) -> FourierSeries<R> {
        FourierSeries::cos(self.ring.clone(), 1)
    }

    fn frequency_factor(&self, displacement: &FourierSeries<R>) -> FourierSeries<R> {
        match self.scheme.detuning {
            Detuning::Acceleration => displacement.derivative().derivative(),
            Detuning::Displacement => displacement.times(-1),
        }
    }

    /// Adds the homogeneous solution that the amplitude convention asks for.
    fn normalised(&self, particular: FourierSeries<R>) -> FourierSeries<R> {
        if self.scheme.normalisation == AmplitudeConvention::FirstHarmonic {
            return particular;
        }
        let sine = particular.derivative().at_zero();
        let with_phase =
            particular.difference(&sine.product(&FourierSeries::sin(self.ring.clone(), 1)));
        match self.scheme.amplitude {
            AmplitudeKind::Determined => with_phase,
            AmplitudeKind::Free => {
                with_phase.difference(&with_phase.at_zero().product(&self.cos_tau()))
            }
        }
    }

    fn push_displacement(&mut self, order: usize, displacement: FourierSeries<R>) {
        let detuned = self.frequency_factor(&displacement);
        self.detuned.push(detuned);
        self.convolutions.push(self.position, displacement.clone());
        self.result.displacement.push(displacement.clone());
        let velocity = match self.scheme.detuning {
            // Time is measured in the frequency itself, which is not expanded here.
            Detuning::Displacement => displacement.derivative(),
            Detuning::Acceleration => {
                let derivatives: Vec<_> =
                    self.result.displacement.iter().map(FourierSeries::derivative).collect();
                let products: Vec<_> = (0..=order)
                    .map(|i| (1, &self.result.frequency[i], &derivatives[order - i]))
                    .collect();
                sum_of_products(self.ring, &products)
            }
        };
        self.convolutions.push(self.velocity, velocity);
        self.convolutions.advance(order);
    }
}

/// A series of order `order`; an error if its ring could not divide by one of its divisors.
fn divided<R: Ring>(
    order: usize,
    series: FourierSeries<R>,
) -> Result<FourierSeries<R>, SecularError> {
    let divided = series.divided();
    divided.map(|()| series).map_err(|indivisible| SecularError::Indivisible { order, indivisible })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::Rational;
    use crate::exact::rational::ratio;
    use crate::series::fourier::fraction;

    fn numbers(series: &[FourierSeries<Integers>]) -> Vec<Rational> {
        series.iter().map(|constant| constant.mean()).map(|(n, d)| fraction(&n, d)).collect()
    }

    pub(super) fn term(
        order: usize,
        position: u32,
        velocity: u32,
        value: (i64, i64),
    ) -> ForceTerm<Integers> {
        let coefficient = FourierSeries::integer(Integers, value.0).divided_by(value.1);
        ForceTerm { order, position, velocity, coefficient }
    }

    fn scheme(amplitude: AmplitudeKind) -> Scheme {
        Scheme {
            normalisation: AmplitudeConvention::Initial,
            amplitude,
            detuning: Detuning::Acceleration,
        }
    }

    #[test]
    fn duffing_and_van_der_pol_from_the_literature() {
        let duffing = expand(&Integers, &[term(1, 3, 0, (1, 1))], 4, &scheme(AmplitudeKind::Free))
            .expect("periodic");
        let expected =
            [ratio(1, 1), ratio(3, 4), ratio(-3, 128), ratio(9, 512), ratio(-1779, 131_072)];
        assert_eq!(numbers(&duffing.frequency_squared), expected);
        // x'' + x + mu (x^2 - 1) x' with x = 2 y: Andersen and Geer 1982.
        let force = [term(1, 2, 1, (4, 1)), term(1, 0, 1, (-1, 1))];
        let cycle = expand(&Integers, &force, 4, &scheme(AmplitudeKind::Determined))
            .expect("a limit cycle");
        let expected = [ratio(1, 1), ratio(0, 1), ratio(-1, 16), ratio(0, 1), ratio(17, 3072)];
        assert_eq!(numbers(&cycle.frequency), expected);
        let amplitudes: Vec<_> =
            cycle.displacement.iter().map(FourierSeries::at_zero).map(|y| y.times(2)).collect();
        let expected = [ratio(2, 1), ratio(0, 1), ratio(1, 96), ratio(0, 1), ratio(-1033, 552_960)];
        assert_eq!(numbers(&amplitudes), expected);
    }

    #[test]
    fn viscous_damping_leaves_a_secular_sine() {
        let damped = expand(&Integers, &[term(1, 0, 1, (2, 1))], 3, &scheme(AmplitudeKind::Free));
        assert_eq!(damped.err(), Some(SecularError::Growth { order: 1 }));
    }
}

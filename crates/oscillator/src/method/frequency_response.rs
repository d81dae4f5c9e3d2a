//! The steady motions of slow equations that are waves of the phase: the frequency-response
//! equation and what follows from it.
//!
//! Reference: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, section 4.1.1.
//!
//! ```text
//! a' = P + P_c cos(psi) + P_s sin(psi),   a psi'/p = Q + Q_c cos(psi) + Q_s sin(psi)
//! both zero, and cos^2 + sin^2 = 1:   P^2 + Q^2 = S^2 for one wave of size S
//! ```
//!
//! Beyond the leading order of the waves, cosine and sine of the phase are found in powers of the
//! small parameter, and the relation is truncated at the order of the equations. These may then
//! contain multiples of the phase, as they do from the third order on; and the truncation removes
//! most of the spurious steady motions that the equations have where the small parameter is not
//! small.

use std::collections::BTreeMap;

use num_traits::{Signed as _, Zero as _};

use crate::exact::Polynomial;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::expr::Expr;
use crate::solution::response::Branches;
use crate::symbol::Symbol;

/// The frequency response of the steady motions, as in `solution::Response`.
pub(super) struct FrequencyResponse {
    pub(super) relation: Option<Polynomial>,
    pub(super) branches: Option<Branches>,
    pub(super) peak: Option<Expr>,
    pub(super) folds: Vec<Expr>,
    pub(super) jumps: Option<Polynomial>,
}

impl FrequencyResponse {
    /// Eliminates the phase from `P` and `Q`, and the cosine and sine of each; the detuning stands
    /// in `Q`.
    pub(super) fn from_rates(
        [rate, phase]: [&Polynomial; 2],
        [[rate_cos, rate_sin], [phase_cos, phase_sin]]: &[[Polynomial; 2]; 2],
        sigma: Symbol,
        a: Symbol,
    ) -> Self {
        let minus = |polynomial: &Polynomial| polynomial.map(|number| -number);
        let square = |polynomial: &Polynomial| polynomial.product(polynomial);
        // If both rates contain the same wave of the phase, only its size matters.
        let one_wave = phase_sin == rate_cos && *phase_cos == minus(rate_sin)
            || *phase_sin == minus(rate_cos) && phase_cos == rate_sin;
        let (drive, relation) = match one_wave {
            true => {
                let drive = square(rate_cos) + square(rate_sin);
                let relation = square(rate) + square(phase) + minus(&drive);
                (Some(drive), relation)
            }
            false => {
                let determinant = rate_cos.product(phase_sin) + minus(&rate_sin.product(phase_cos));
                let cosine = rate_sin.product(phase) + minus(&rate.product(phase_sin));
                let sine = phase_cos.product(rate) + minus(&rate_cos.product(phase));
                (None, square(&cosine) + square(&sine) + minus(&square(&determinant)))
            }
        };
        if rate.is_zero() && phase.is_zero() {
            // At this order no term balances the wave.
            return Self::of_relation(None, a);
        }
        let relation = without_common_powers(&relation);
        // sigma = centre + and - the root of the square of a width, if the wave does not contain it
        // and the rest is linear in it.
        let by_sigma = Monomial::power_of(sigma, 1).product(&Monomial::power_of(a, 1));
        let weight = phase.coefficient(&by_sigma);
        let mut centre = phase.clone();
        centre.add_term(by_sigma, -weight.clone());
        let free = |polynomial: &Polynomial| !polynomial.symbols().contains(&sigma);
        let mut branches = None;
        let mut peak = None;
        if let Some(drive) = drive
            .as_ref()
            .filter(|drive| !weight.is_zero() && free(drive) && free(&centre) && free(rate))
        {
            let over = Polynomial::term(Monomial::power_of(a, -1), weight.recip());
            let width = (drive.clone() + minus(&square(rate))).product(&square(&over));
            branches =
                Some(Branches { centre: minus(&centre.product(&over)), width_squared: width });
            peak = peak_of(rate, drive, a);
        }
        let (folds, jumps) = folds(&relation, a);
        Self { relation: Some(relation), branches, peak, folds, jumps }
    }

    /// Replaces the relation by `relation`, truncated at the order of the rates, if that is given.
    pub(super) fn cut(self, relation: Option<Polynomial>, a: Symbol) -> Self {
        match relation {
            None => self,
            found => {
                Self { branches: self.branches, peak: self.peak, ..Self::of_relation(found, a) }
            }
        }
    }

    /// A response that consists of its relation alone.
    pub(super) fn of_relation(relation: Option<Polynomial>, a: Symbol) -> Self {
        let relation = relation.map(|relation| without_common_powers(&relation));
        let (folds, jumps) =
            relation.as_ref().map_or((vec![], None), |relation| folds(relation, a));
        Self { relation, branches: None, peak: None, folds, jumps }
    }
}

/// A rate as waves of the phase: the coefficients of cosine and sine, by the multiple of the phase.
pub(super) type PhaseWaves = BTreeMap<u32, [Polynomial; 2]>;

/// The coefficients of the cosine and the sine of the phase itself.
pub(super) fn turning(rate: &PhaseWaves) -> [Polynomial; 2] {
    let zero = || [Polynomial::zero(), Polynomial::zero()];
    rate.get(&1).cloned().unwrap_or_else(zero)
}

/// The relation between amplitude and detuning of two rates with multiples of the phase, in powers
/// of a marker up to the order of the rates; `None` unless the waves of the phase itself lead and
/// determine its cosine and sine, all multiples are of higher order, and the rates have an order
/// above the leading one.
///
/// ```text
/// M (c, s) = -(all else at c, s),   M the waves that lead:   c, s order by order,   c^2 + s^2 = 1
/// ```
pub(super) fn eliminated(
    rates: [&PhaseWaves; 2],
    marker: Symbol,
    order: i32,
    inverse: Symbol,
) -> Option<Polynomial> {
    let lowest = |polynomial: &Polynomial| polynomial.exponent_range(marker).map(|range| range.0);
    let earliest = |wanted: &dyn Fn(u32) -> bool| {
        let waves = rates.iter().flat_map(|rate| rate.iter());
        let waves = waves.filter(|(multiple, _)| wanted(**multiple));
        waves.flat_map(|(_, waves)| waves.iter().filter_map(lowest)).min()
    };
    let leading = earliest(&|multiple| multiple == 1)?;
    let after = |found: Option<i32>, least: i32| found.is_none_or(|found| found >= least);
    if !after(earliest(&|multiple| multiple == 0), leading)
        || !after(earliest(&|multiple| multiple > 1), leading + 1)
    {
        return None;
    }
    let highest = order - leading;
    if highest == 0 {
        return None;
    }
    let cut = |polynomial: &Polynomial| polynomial.truncated(marker, highest);
    let minus = |polynomial: &Polynomial| polynomial.map(|number| -number);
    // From here on the marker counts from the leading order.
    let down = Monomial::power_of(marker, -leading);
    let matrix =
        rates.map(|rate| turning(rate).map(|wave| wave.times_monomial(&down).truncated(marker, 0)));
    let [[a, b], [c, d]] = &matrix;
    let determinant = a.product(d) + minus(&b.product(c));
    if determinant.is_zero() {
        return None;
    }
    let over = Polynomial::symbol(inverse);
    let (mut cosine, mut sine) = (Polynomial::zero(), Polynomial::zero());
    for _ in 0..=highest {
        let rest = |rate: &PhaseWaves, [by_cos, by_sin]: &[Polynomial; 2]| {
            let mut sum = minus(&(by_cos.product(&cosine) + by_sin.product(&sine)));
            for (multiple, waves) in rate {
                for (wave, value) in
                    waves.iter().zip(multiple_of(*multiple, [&cosine, &sine], &cut))
                {
                    sum.accumulate(&cut(&wave.times_monomial(&down).product(&value)));
                }
            }
            cut(&sum)
        };
        let [one, other] = [rest(rates[0], &matrix[0]), rest(rates[1], &matrix[1])];
        let solved = [
            b.product(&other) + minus(&d.product(&one)),
            c.product(&one) + minus(&a.product(&other)),
        ];
        [cosine, sine] = solved.map(|value| cut(&value.product(&over)));
    }
    // If all other terms are d orders higher than the waves, so are c and s, and their squares are
    // known to as many orders beyond their leading one: that is twice d.
    let behind = [&cosine, &sine].into_iter().filter_map(lowest).min()?;
    let squares = cosine.product(&cosine) + sine.product(&sine);
    let mut relation = squares.truncated(marker, highest + behind);
    relation.add_term(Monomial::one(), ratio(-1, 1));
    // The relation is multiplied by the determinant until no denominator is left.
    let most = relation.exponent_range(inverse)?.1;
    let mut whole = Polynomial::zero();
    for (monomial, number) in relation.terms() {
        let times = determinant.power(most - monomial.exponent(inverse))?;
        let term = Polynomial::term(monomial.without(inverse), number.clone());
        whole.accumulate(&term.product(&times));
    }
    // For one wave of size S the determinant is S^2: one factor suffices for P^2 + Q^2 = S^2.
    Some(match determinant.map(|number| number.abs()).power(1 - most) {
        Some(less) => whole.product(&less),
        None => whole,
    })
}

/// Cosine and sine of a multiple of an angle, from those of the angle.
fn multiple_of(
    multiple: u32,
    [cosine, sine]: [&Polynomial; 2],
    cut: &dyn Fn(&Polynomial) -> Polynomial,
) -> [Polynomial; 2] {
    let mut found = [Polynomial::constant(ratio(1, 1)), Polynomial::zero()];
    for _ in 0..multiple {
        let [c, s] = &found;
        let across = s.product(sine).map(|number| -number);
        found = [cut(&(c.product(cosine) + across)), cut(&(s.product(cosine) + c.product(sine)))];
    }
    found
}

/// A relation with the powers that all terms have in common taken out.
fn without_common_powers(relation: &Polynomial) -> Polynomial {
    relation.symbols().into_iter().fold(relation.clone(), |rest, name| {
        let lowest = rest.exponent_range(name).map_or(0, |range| range.0);
        rest.times_monomial(&Monomial::power_of(name, -lowest))
    })
}

/// The largest amplitude, where `P^2 = S^2` where `P` is one power of the amplitude, or linear
/// damping plus dry friction, and `S` does not contain it. Symbols count as positive.
fn peak_of(rate: &Polynomial, drive: &Polynomial, a: Symbol) -> Option<Expr> {
    if drive.symbols().contains(&a) {
        return None;
    }
    let size = drive.single_term_root()?;
    if let Some((monomial, number)) = rate.single_term() {
        let power = monomial.exponent(a);
        if power < 1 {
            return None;
        }
        let pace = Polynomial::term(monomial.without(a), number.abs());
        let quotient = size.product(&pace.power(-1)?);
        return Expr::power(&Expr::from(&quotient), &Expr::number(ratio(1, power.into()))).ok();
    }
    let [(by, pace), (held, friction)] = [1, 0].map(|power| {
        let mut terms = rate.terms().filter(|(monomial, _)| monomial.exponent(a) == power);
        let found = terms.next().filter(|(_, number)| number.is_negative());
        let only = found.filter(|_| terms.next().is_none());
        only.map_or((None, None), |(monomial, number)| {
            (Some(monomial.without(a)), Some(-number.clone()))
        })
    });
    let pace = Polynomial::term(by?, pace?);
    let friction = Polynomial::term(held?, friction?);
    if rate.terms().len() != 2 {
        return None;
    }
    let left = &Expr::from(&size) - &Expr::from(&friction);
    Expr::divide(&left, &Expr::from(&pace)).ok()?.expand().ok()
}

/// The coefficients of a polynomial in the square of the amplitude, lowest first; `None` if it has
/// odd powers.
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

/// Folds of the frequency response: the squared amplitudes at which two steady motions meet, by the
/// detuning, and the discriminant that vanishes there.
fn folds(relation: &Polynomial, a: Symbol) -> (Vec<Expr>, Option<Polynomial>) {
    let Some(coefficients) = in_square(relation, a) else {
        return (vec![], None);
    };
    let product = |factors: &[&Polynomial], number: i64| {
        let start = Polynomial::constant(ratio(number, 1));
        factors.iter().fold(start, |product, factor| product.product(factor))
    };
    match coefficients.as_slice() {
        [c, b, a] => {
            (vec![], Some(without_common_powers(&(product(&[b, b], 1) + product(&[a, c], -4)))))
        }
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

/// A polynomial as the square of a single term times the rest, which stays under the root.
fn squares_apart(polynomial: &Polynomial) -> Option<(Polynomial, Polynomial)> {
    let mut outside = Monomial::one();
    for name in polynomial.symbols() {
        let (lowest, _) = polynomial.exponent_range(name)?;
        outside = outside.product(&Monomial::power_of(name, lowest.div_euclid(2)));
    }
    let inside = polynomial.times_monomial(&outside.power(-2));
    Some((Polynomial::term(outside, ratio(1, 1)), inside))
}

//! omega^2 as a power series in one variable, with what its symbols have in common taken out.

use num_traits::Zero;

use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, Rational};
use crate::solution::Solution;
use crate::symbol::Symbol;

/// omega^2 in powers of `s`, the small parameter or its square.
pub(crate) struct PowerSeries {
    pub law: Polynomial,
    pub small: Symbol,
    /// The power of the small parameter that `s` is.
    pub step: i32,
}

impl PowerSeries {
    /// In the squared amplitude where the series has even powers alone.
    pub fn of(solution: &Solution, in_amplitude: bool) -> Self {
        let small = solution.small_parameter;
        let law = solution.law.frequency_squared().cloned();
        let law = law.unwrap_or_else(Polynomial::zero);
        let even = law.terms().all(|(monomial, _)| monomial.exponent(small) % 2 == 0);
        Self {
            law,
            small,
            step: if in_amplitude && even { 2 } else { 1 },
        }
    }

    /// `c_k`; zero for a negative power.
    pub fn coefficient(&self, power: i64) -> Polynomial {
        match u32::try_from(power) {
            Ok(power) => part(&self.law, self.small, self.step * power as i32),
            Err(_) => Polynomial::zero(),
        }
    }

    /// `c_0 + c_1 s + ...` of other coefficients.
    pub fn with_powers(&self, coefficients: &[Polynomial]) -> Polynomial {
        let mut sum = Polynomial::zero();
        for (power, coefficient) in coefficients.iter().enumerate() {
            sum.accumulate(&coefficient.times_monomial(&Monomial::power_of(self.small, self.step * power as i32)));
        }
        sum
    }

    /// The series in one variable, where all other symbols enter in step with `s`: the variable, `s` times a unit of theirs, and the
    /// coefficients in it over the first, as many as the law has powers.
    pub fn in_one_variable(&self) -> Option<(Monomial, Vec<Rational>)> {
        let (_, highest) = self.law.exponent_range(self.small)?;
        let coefficients: Vec<Polynomial> = (0..=i64::from(highest / self.step))
            .map(|power| self.coefficient(power))
            .collect();
        let (unit, numbers) = scaled(&coefficients)?;
        Some((Monomial::power_of(self.small, self.step).product(&unit), numbers))
    }
}

/// The terms of one power of the small parameter, without it.
fn part(law: &Polynomial, small: Symbol, power: i32) -> Polynomial {
    let mut part = Polynomial::zero();
    for (monomial, number) in law.terms().filter(|(monomial, _)| monomial.exponent(small) == power) {
        part.add_term(monomial.without(small), number.clone());
    }
    part
}

/// The numbers `n_k` of a series `c_k = c_0 unit^k n_k` whose symbols enter in step with the order, and the unit.
pub(crate) fn scaled(series: &[Polynomial]) -> Option<(Monomial, Vec<Rational>)> {
    let (base, _) = series.first()?.single_term()?;
    let ratio = |c: &Polynomial| Some(c.single_term()?.0.product(&base.power(-1)));
    let (k, first) = (1..).zip(&series[1..]).find(|(_, c)| !c.is_zero())?;
    let mut unit = Monomial::one();
    for &(symbol, exponent) in ratio(first)?.factors() {
        unit = unit.product(&Monomial::power_of(
            symbol,
            (exponent % k == 0).then_some(exponent / k)?,
        ));
    }
    let number = |(k, c): (i32, &Polynomial)| match c.is_zero() {
        true => Some(Rational::zero()),
        false => (ratio(c)? == unit.power(k)).then(|| c.single_term().map(|term| term.1.clone()))?,
    };
    let numbers: Option<Vec<Rational>> = (0..).zip(series).map(number).collect();
    Some((unit, numbers?))
}

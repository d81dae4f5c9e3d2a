//! The initial amplitude and phase of a motion released from rest, as series in the small
//! parameter.
//!
//! ```text
//! x(a, theta) = A,   x' = a' x_a + theta' x_theta = 0 at t = 0,   x = a cos(theta) + ...
//! a <- a + A - x(a, theta),   theta <- theta + x'(a, theta)/(A omega0)     an order more with each step, from a = A, theta = 0
//! ```

use num_traits::Zero as _;

use super::names::ExpansionSymbols;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::ratio;
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials};
use crate::series::FourierSeries;
use crate::solution::AmplitudeConvention;
use crate::symbol::Symbol;

/// `a(0)` and `theta(0)` in `A`, up to an order of the marker, from the motion and its slow
/// equations; `None` if they have powers of the amplitude below zero.
pub(super) fn release(
    motion: &FourierSeries<Polynomials>,
    [amplitude_rate, phase_rate]: [&Polynomial; 2],
    linear_frequency: &Polynomial,
    names: &ExpansionSymbols,
    order: usize,
) -> Option<[Polynomial; 2]> {
    let highest = i32::try_from(order).ok()?;
    let cut = |polynomial: &Polynomial| polynomial.truncated(names.marker, highest);
    let constant = |polynomial: &Polynomial| FourierSeries::constant(POLYNOMIALS, cut(polynomial));
    let a = names.amplitude;
    let motion = motion.map(POLYNOMIALS, |coefficient, _| cut(coefficient));
    let by_amplitude = motion.map(POLYNOMIALS, |coefficient, _| coefficient.slope(a));
    let velocity = by_amplitude
        .product(&constant(amplitude_rate))
        .sum(&motion.derivative().product(&constant(phase_rate)));
    let start = AmplitudeConvention::Initial.symbol();
    let over = Polynomial::term(Monomial::power_of(start, -1), ratio(1, 1))
        .product(&linear_frequency.power(-1)?);
    let minus = Polynomial::constant(ratio(-1, 1));
    let (mut amplitude, mut phase) = (Polynomial::symbol(start), Polynomial::zero());
    for _ in 0..order {
        let place = value(&motion, a, [&amplitude, &phase], highest.into(), &cut)?;
        let speed = value(&velocity, a, [&amplitude, &phase], highest.into(), &cut)?;
        amplitude = cut(&(amplitude + Polynomial::symbol(start) + place.product(&minus)));
        phase = cut(&(phase + speed.product(&over)));
    }
    Some([amplitude, phase])
}

/// The value of a series at an amplitude and a phase that vanishes with the small parameter.
fn value(
    series: &FourierSeries<Polynomials>,
    a: Symbol,
    [amplitude, phase]: [&Polynomial; 2],
    order: i64,
    cut: &dyn Fn(&Polynomial) -> Polynomial,
) -> Option<Polynomial> {
    let mut sum = Polynomial::zero();
    for (harmonic, cosine, sine) in series.harmonics() {
        let angle = phase.product(&Polynomial::constant(ratio(i64::try_from(harmonic).ok()?, 1)));
        let [cos, sin] = waves(&angle, order, cut);
        for (coefficient, wave) in [(cosine, cos), (sine, sin)] {
            let coefficient = cut(&coefficient.substitute(a, amplitude)?);
            sum.accumulate(&cut(&coefficient.product(&wave)));
        }
    }
    Some(sum)
}

/// Cosine and sine of an angle that is small, by their power series.
fn waves(
    angle: &Polynomial,
    order: i64,
    cut: &dyn Fn(&Polynomial) -> Polynomial,
) -> [Polynomial; 2] {
    let (mut cos, mut sin) = (Polynomial::zero(), Polynomial::zero());
    let mut term = Polynomial::constant(ratio(1, 1));
    for power in 0..=order {
        // 1, x, -x^2/2, -x^3/6, ...
        let (sum, sign) = match power % 2 {
            0 => (&mut cos, 1),
            _ => (&mut sin, -1),
        };
        sum.accumulate(&term);
        term = cut(&term.product(angle).product(&Polynomial::constant(ratio(sign, power + 1))));
    }
    [cos, sin]
}

//! Several drives without a ratio of their frequencies: one near the linear frequency, the others
//! far from every resonance.
//!
//! Reference: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, sections 4.1 and 4.4.
//!
//! ```text
//! x'' + omega0^2 x + eps f(x, x') = F cos(Omega t) + sum F_j cos(W_j t),      Omega near omega0
//! x = u + sum 2 Lambda_j cos(W_j t),   Lambda_j = F_j/(2 (omega0^2 - W_j^2))
//! u'' + omega0^2 u + eps <f(u + sum 2 Lambda_j cos(phi_j), u' - sum 2 Lambda_j W_j sin(phi_j))> = F cos(Omega t) + ...
//! ```
//!
//! The slow equations of a motion with drives far from resonance are known beforehand. To first
//! order they are those of the force averaged over the phases `phi_j`, because no combination of
//! the frequencies is near omega0: `<(u + 2 Lambda cos phi)^3> = u^3 + 6 Lambda^2 u`.

use std::collections::BTreeMap;

use num_traits::{One as _, Zero as _};

use super::drive::{HarmonicExcitation, Quadrature};
use super::multiple_scales::scaling::has_quadratic_terms;
use super::resonance::{RESONANCES, ratio_of};
use super::{Options, solve_by};
use crate::exact::rational::ratio;
use crate::exact::{Polynomial, Rational};
use crate::expr::{Equation, Expr, Typed};
use crate::oscillator::{Oscillator, SmallParameter};
use crate::solution::{Definition, Method, Note, Solution};
use crate::symbol::{Symbol, fresh};

/// A drive far from resonance, and the symbols of its forced motion.
struct Forced {
    wave: HarmonicExcitation,
    /// `Lambda`.
    size: Definition,
    /// The cosine and the sine of its phase, and its frequency, which stand for themselves while
    /// the force is averaged.
    letters: [Symbol; 3],
}

/// The answer to the first order in a small parameter; `None` if there is no such parameter, if a
/// drive is not a force free of the motion, or if the frequencies that are numbers are near another
/// resonance.
pub(super) fn solve(oscillator: &Oscillator, options: &Options) -> Option<Solution> {
    let by_scales = options.method.is_none_or(|method| method == Method::MultipleScales);
    let first_order = options.order.is_none_or(|order| order == 1);
    if !by_scales || !first_order || options.resonance.is_some_and(|asked| asked != (1, 1)) {
        return None;
    }
    let SmallParameter::Parameter(small) =
        oscillator.small_parameter(options.small.as_deref()).ok()?
    else {
        return None;
    };
    let parts = oscillator.parts().ok()?;
    let waves: Option<Vec<HarmonicExcitation>> =
        parts.forcing.terms().iter().map(|term| as_free_force(term, oscillator)).collect();
    let waves = waves?;
    let mut free = oscillator.clone();
    free.force = (&oscillator.force - &parts.forcing).expand().ok()?;
    if has_quadratic_terms(&free) {
        return None;
    }
    let without_small = parts.restoring.substitute(small, &Expr::zero()).ok()?.expand().ok()?;
    let x = Expr::from(oscillator.coordinate);
    let stiffness = without_small.differentiate(oscillator.coordinate).ok()?.expand().ok()?;
    let is_linear =
        |force: &Expr| (force - &(&stiffness * &x)).expand().is_ok_and(|rest| rest.is_zero());
    if !is_linear(&without_small) || stiffness.is_zero() {
        return None;
    }
    let near = nearest(&waves, small, &stiffness);
    let (kept, others): (Vec<HarmonicExcitation>, Vec<HarmonicExcitation>) = waves
        .into_iter()
        .partition(|wave| number_between(&wave.rate, &near).is_some_and(|number| number.is_one()));
    // Waves whose frequencies have a rational ratio act together, and are not averaged apart.
    let alone = |(k, wave): (usize, &HarmonicExcitation)| {
        let mut rest = kept.iter().chain(&others[k + 1..]);
        !rest.any(|other| number_between(&wave.rate, &other.rate).is_some())
            && is_far(&wave.rate, &stiffness)
    };
    if others.is_empty() || !others.iter().enumerate().all(alone) {
        return None;
    }
    let forced = forced(others, &stiffness, oscillator)?;
    let averaged = averaged(&free.force, &forced, oscillator)?;
    let velocity = oscillator.velocity();
    let mut still = averaged.clone();
    for name in [small, velocity] {
        still = still.substitute(name, &Expr::zero()).ok()?;
    }
    // With a nonlinear force that is not small the other drives would shift the linear frequency
    // itself.
    if !is_linear(&still.expand().ok()?) {
        return None;
    }
    let drives = kept.iter().map(wave_term).collect::<Option<Vec<Expr>>>()?;
    let equation = Equation {
        left: Expr::from(velocity.derivative()) + averaged + Expr::sum(drives),
        right: Expr::zero(),
        coordinate: oscillator.coordinate,
        typed: Typed::default(),
    };
    let seen = Oscillator::from_equation(&equation).ok()?;
    let asked = Options { order: Some(1), small: Some(small.to_string()), ..options.clone() };
    let solution = solve_by(Method::MultipleScales, &seen, &asked).ok()?;
    of_the_whole(solution, &forced, near, oscillator)
}

/// The answer of the averaged equation as one of the equation with all its drives: the motion to
/// leading order.
fn of_the_whole(
    mut solution: Solution,
    forced: &[Forced],
    near: Expr,
    oscillator: &Oscillator,
) -> Option<Solution> {
    let still: BTreeMap<Symbol, Expr> =
        solution.small_parameters().map(|name| (name, Expr::zero())).collect();
    let response = solution.response.as_mut()?;
    let mut motion = vec![response.motion.substitute_all(&still).ok()?];
    for own in forced {
        let [cosine, sine] = carrier(&own.wave)?;
        let wave = match own.wave.quadrature {
            Quadrature::Cosine => cosine,
            Quadrature::Sine => sine,
        };
        motion.push(Expr::from(2) * Expr::from(own.size.symbol) * wave);
    }
    response.motion = Expr::sum(motion);
    solution.equation = oscillator.equation();
    solution.parameters.clone_from(&oscillator.parameters);
    solution.definitions.extend(forced.iter().map(|own| own.size.clone()));
    solution.validity.push(Note::ForcedWaves {
        near,
        far: forced.iter().map(|own| own.wave.rate.clone()).collect(),
    });
    Some(solution)
}

/// A drive that is a force free of the motion; `None` for any other.
fn as_free_force(term: &Expr, oscillator: &Oscillator) -> Option<HarmonicExcitation> {
    let wave = HarmonicExcitation::new(term, Method::MultipleScales).ok()?;
    let own = [oscillator.coordinate, oscillator.velocity()];
    let moves = |part: &Expr| own.iter().any(|name| part.contains(*name));
    (!moves(&wave.factor) && !moves(&wave.phase) && !moves(&wave.rate)).then_some(wave)
}

/// The frequency that is taken to be near the linear one: the nearest, where all are numbers; else
/// that of the drive which the small parameter makes as small as the damping; else the first.
fn nearest(waves: &[HarmonicExcitation], small: Symbol, stiffness: &Expr) -> Expr {
    let distances: Option<Vec<f64>> = waves
        .iter()
        .map(|wave| ratio_of(&wave.rate, stiffness).map(|ratio| ratio.ln().abs()))
        .collect();
    let by_numbers = distances.and_then(|distances| {
        let all = distances.iter().enumerate();
        all.min_by(|one, other| one.1.total_cmp(other.1)).map(|(k, _)| k)
    });
    let weak = || waves.iter().position(|wave| wave.factor.contains(small));
    let chosen = by_numbers.or_else(weak).unwrap_or(0);
    waves.get(chosen).map_or_else(Expr::one, |wave| wave.rate.clone())
}

/// Whether a frequency is not known to be near one at which a cubic or a quadratic force would be
/// in resonance.
fn is_far(rate: &Expr, stiffness: &Expr) -> bool {
    /// Largest detuning, relative to the frequency, that still counts as near.
    const NEAR: f64 = 0.1;
    let is_near =
        |ratio: f64, (p, q): (u32, u32)| (ratio * f64::from(q) / f64::from(p) - 1.0).abs() < NEAR;
    ratio_of(rate, stiffness)
        .is_none_or(|ratio| !RESONANCES.into_iter().any(|known| is_near(ratio, known)))
}

/// The ratio of two frequencies, where it is a positive number.
fn number_between(one: &Expr, other: &Expr) -> Option<Rational> {
    let quotient = Expr::divide(one, other).ok()?.expand().ok()?;
    quotient.as_number().cloned()
}

fn carrier(wave: &HarmonicExcitation) -> Option<[Expr; 2]> {
    let angle = &(&wave.rate * &Expr::symbol("t")) + &wave.phase;
    Some([angle.cos().ok()?, angle.sin().ok()?])
}

/// The drive as a term of the left side.
fn wave_term(wave: &HarmonicExcitation) -> Option<Expr> {
    let [cosine, sine] = carrier(wave)?;
    Some(match wave.quadrature {
        Quadrature::Cosine => &wave.factor * &cosine,
        Quadrature::Sine => &wave.factor * &sine,
    })
}

fn forced(
    waves: Vec<HarmonicExcitation>,
    stiffness: &Expr,
    oscillator: &Oscillator,
) -> Option<Vec<Forced>> {
    let mut taken = oscillator.names();
    let mut name = |wanted: &str| {
        let name = fresh(wanted, &taken);
        taken.push(name);
        name
    };
    let several = waves.len() > 1;
    let mut found = vec![];
    for (k, wave) in waves.into_iter().enumerate() {
        let number = if several { (k + 1).to_string() } else { String::new() };
        let squared = wave.rate.integer_power(2).ok()?;
        let below = Expr::from(2) * (stiffness - &squared).expand().ok()?;
        // The drive stands on the left side of the equation.
        let meaning = Expr::divide(&-&wave.factor, &below).ok()?;
        let symbol = name(&format!("Lambda{number}"));
        found.push(Forced {
            wave,
            size: Definition { symbol, meaning },
            letters: ["c", "s", "r"].map(|letter| name(&format!("{letter}{}", k + 1))),
        });
    }
    Some(found)
}

/// The force along the motion and the forced waves, averaged over the phases of these; what does
/// not depend on the motion, which shifts it by a part as small as the force, is left out.
fn averaged(force: &Expr, forced: &[Forced], oscillator: &Oscillator) -> Option<Expr> {
    let own = [oscillator.coordinate, oscillator.velocity()];
    let mut along = own.map(Expr::from);
    for Forced { wave, size, letters } in forced {
        let [cosine, sine, rate] = letters.map(Expr::from);
        let (place, turned) = match wave.quadrature {
            Quadrature::Cosine => (cosine, -&sine),
            Quadrature::Sine => (sine, cosine),
        };
        let twice = Expr::from(2) * Expr::from(size.symbol);
        along[0] = &along[0] + &(&twice * &place);
        along[1] = &along[1] + &(&(&twice * &rate) * &turned);
    }
    let [place, speed] = along;
    let there = BTreeMap::from([(own[0], place), (own[1], speed)]);
    let moved = force.substitute_all(&there).ok()?.expand().ok()?;
    let polynomial = moved.to_polynomial(&mut |_| None).ok()??;
    let mut sum = Polynomial::zero();
    for (monomial, number) in polynomial.terms() {
        if own.iter().all(|name| monomial.exponent(*name) == 0) {
            continue;
        }
        let (mut rest, mut factor) = (monomial.clone(), number.clone());
        for [cosine, sine, _] in forced.iter().map(|own| own.letters) {
            factor *= mean(rest.exponent(cosine), rest.exponent(sine));
            rest = rest.without(cosine).without(sine);
        }
        if !factor.is_zero() {
            sum.add_term(rest, factor);
        }
    }
    let rates = forced.iter().map(|own| (own.letters[2], own.wave.rate.clone()));
    Expr::from(&sum).substitute_all(&rates.collect()).ok()
}

/// The mean of `cos^m sin^n` over a turn: `(m - 1)!! (n - 1)!!/(m + n)!!` where both are even, else
/// zero.
fn mean(m: i32, n: i32) -> Rational {
    if m % 2 != 0 || n % 2 != 0 {
        return Rational::zero();
    }
    // Each pair of factors of either: <c^m s^n> = (m - 1)/(m + n) <c^(m-2) s^n>.
    let mut value = Rational::one();
    let (mut m, mut n) = (i64::from(m), i64::from(n));
    while m + n > 0 {
        let which = if m > 0 { &mut m } else { &mut n };
        let odd = *which - 1;
        *which -= 2;
        value *= ratio(odd, m + n + 2);
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The means by a sum over equal steps, which is exact for few harmonics.
    #[test]
    fn means_of_powers_of_waves() {
        const STEPS: i32 = 64;
        for (m, n) in
            [(0, 0), (1, 0), (2, 0), (0, 2), (2, 2), (4, 0), (4, 2), (6, 4), (3, 2), (1, 1)]
        {
            let angles =
                (0..STEPS).map(|k| std::f64::consts::TAU * f64::from(k) / f64::from(STEPS));
            let sum: f64 = angles.map(|angle| angle.cos().powi(m) * angle.sin().powi(n)).sum();
            let found = crate::exact::rational::to_f64(&mean(m, n));
            assert!((found - sum / f64::from(STEPS)).abs() < 1e-14, "cos^{m} sin^{n}: {found}");
        }
    }
}

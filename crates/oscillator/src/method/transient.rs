//! The amplitude equation solved from its start, where it has a closed solution, and the phase
//! after it.
//!
//! References: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, section 3.3
//! (viscous, Coulomb and quadratic damping, van der Pol); E. L. Ince, *Ordinary Differential
//! Equations*, Dover 1956, section 2.15 (Bernoulli's equation).
//!
//! ```text
//! a' = c a^n               a = A exp(c t);     a^(1-n) = A^(1-n) + (1 - n) c t
//! a' = c a + d             a = (A + d/c) exp(c t) - d/c
//! a' = c a + d a^m         a^(1-m) = (A^(1-m) + d/c) exp((1 - m) c t) - d/c
//! a' = -c - d a^2          a = sqrt(c/d) tan(atan(A sqrt(d/c)) - sqrt(c d) t)
//! psi' = sum d_k a^k       by  (a^j)'/j = sum c_i a^(n_i + j - 1)  and  (log a)' = sum c_i a^(n_i - 1)
//! ```
//!
//! Parameters count as positive: their signs decide where a motion ends and which form of a
//! solution is written.

use num_traits::{One as _, Signed as _, Zero as _};

use crate::decimal::rounded;
use crate::exact::Rational;
use crate::exact::rational::ratio;
use crate::expr::{CompiledFunction, Expr, ExprError, Function, Node};
use crate::numeric::ode::root::find_root;
use crate::solution::modulation::{Release, Transient};
use crate::solution::{Definition, LeadingCycle};
use crate::symbol::letters::FIRST_HARMONIC;
use crate::symbol::{Symbol, fresh};

/// The motion of slow equations from where it is released, with the names `a0` and `psi0`, or
/// others where these are taken, for initial values that are more than a symbol.
pub(crate) fn from_release(
    a: Symbol,
    [rate, phase_rate]: [&Expr; 2],
    release: &mut Release,
    taken: &[Symbol],
) -> (Vec<Definition>, Option<Transient>) {
    let mut definitions = vec![];
    let mut named = |wanted: &str, meaning: &mut Expr| {
        if meaning.is_zero() || meaning.as_symbol().is_some() {
            return meaning.clone();
        }
        let symbol = fresh(wanted, taken);
        let meaning = std::mem::replace(meaning, Expr::from(symbol));
        definitions.push(Definition { symbol, meaning });
        Expr::from(symbol)
    };
    let start = named(&format!("{FIRST_HARMONIC}0"), &mut release.amplitude);
    let phase = named("psi0", &mut release.phase);
    let found = closed_form(a, rate, phase_rate, [&start, &phase]);
    (definitions, found)
}

/// The amplitude and the phase from their values at the start, the first of which is a symbol;
/// `None` if the amplitude has no closed form here.
fn closed_form(
    a: Symbol,
    rate: &Expr,
    phase_rate: &Expr,
    [start, begins]: [&Expr; 2],
) -> Option<Transient> {
    let law = PowerLaw::from_rate(rate, a)?;
    let (amplitude, ends) = law.solved(start)?;
    let phase = law.phase(phase_rate, a, &amplitude, start);
    Some(Transient {
        start: start.as_symbol()?,
        amplitude: merge_exponentials(&amplitude)?,
        phase: phase.and_then(|phase| merge_exponentials(&(begins + &phase))),
        ends,
    })
}

/// Powers of exponentials as exponentials: `exp(u)^2 = exp(2 u)`.
fn merge_exponentials(expression: &Expr) -> Option<Expr> {
    let tidied: Result<Expr, ExprError> = expression.fold(|expr, children: &[Expr]| {
        let whole = expr.with_children(children)?;
        let (base, exponent) = whole.base_and_exponent();
        match base.node() {
            Node::Function(Function::Exp, arguments) if !exponent.is_one() => {
                let argument = (&arguments[0] * &exponent).expand()?;
                Expr::function(Function::Exp, vec![argument])
            }
            _ => Ok(whole),
        }
    });
    tidied.ok()
}

/// The steady amplitudes, each with its stability: the one at which the two terms of a rate
/// balance, where it is positive; or, for a rate that is not a sum of powers, those found
/// numerically, where parameters enter only as a factor and as a scale of the amplitude.
pub(crate) fn steady(a: Symbol, rate: &Expr) -> Vec<LeadingCycle> {
    let balance = || {
        let law = PowerLaw::from_rate(rate, a)?;
        let [(p, c), (q, d)] = law.0.as_slice() else {
            return None;
        };
        // The lower power first, where both are numbers.
        let lower_is_first = p.as_number()? < q.as_number()?;
        let (lower, power) = if lower_is_first { (c, q - p) } else { (d, p - q) };
        let other = if lower_is_first { d } else { c };
        let size = (-&Expr::divide(lower, other).ok()?).expand().ok()?;
        // The sign of a sum depends on the values of its parameters.
        let is_sum = size.terms().len() > 1;
        if size.has_leading_minus() && !is_sum {
            return None;
        }
        let amplitude = Expr::power(&size, &Expr::divide(&Expr::one(), &power).ok()?).ok()?;
        // If the leading term feeds energy, the higher one, which overtakes it, dissipates it.
        let feeds = if is_sum { -other } else { lower.clone() };
        let (number, factors) = feeds.factors();
        let sign = Expr::number(number.signum());
        let letters = factors.iter().filter(|factor| !factor.symbols().is_empty()).cloned();
        Some(LeadingCycle { amplitude, attracts_where: Some(sign * Expr::product(letters)) })
    };
    match PowerLaw::from_rate(rate, a) {
        Some(_) => balance().into_iter().collect(),
        None => steady_by_numbers(a, rate).unwrap_or_default(),
    }
}

/// The zeros of a rate `factor * scale^n * g(a/scale)`, where `g` contains no parameter; `None` for
/// any other.
fn steady_by_numbers(a: Symbol, rate: &Expr) -> Option<Vec<LeadingCycle>> {
    /// Hundredths of the decimal logarithms of the amplitudes searched, in units of the scale.
    const GRID: std::ops::RangeInclusive<i32> = -300..=300;
    const PER_DECADE: f64 = 100.0;
    let letters: Vec<Symbol> = rate.symbols().into_iter().filter(|name| *name != a).collect();
    let powers = [ratio(1, 2), ratio(-1, 2)];
    let of_letters = letters.iter().flat_map(|name| {
        let letter = Expr::from(*name);
        let size = Expr::function(Function::Absolute, vec![letter.clone()]).ok();
        let inverses =
            [Some(&letter), size.as_ref()].map(|scale| Expr::divide(&Expr::one(), scale?).ok());
        let power =
            |exponent: &Rational| Expr::power(&letter, &Expr::number(exponent.clone())).ok();
        let roots = powers.iter().map(power);
        let scales = [Some(letter.clone()), size].into_iter().chain(inverses).chain(roots);
        scales.flatten().collect::<Vec<Expr>>()
    });
    std::iter::once(Expr::one()).chain(of_letters).find_map(|scale| {
        let scaled = rate.substitute(a, &(&scale * &Expr::from(a))).ok()?.expand().ok()?;
        // Factors that every term has in common with the first.
        let (number, factors) = scaled.terms().first()?.factors();
        let (outside, _): (Vec<Expr>, Vec<Expr>) =
            factors.iter().cloned().partition(|factor| !factor.contains(a));
        let letters = outside.into_iter().filter(|factor| !factor.symbols().is_empty());
        let letters: Vec<Expr> = letters.collect();
        let common = Expr::product(letters.iter().cloned());
        // The scale is positive and decides no sign.
        let (of_scale, _) = scale.base_and_exponent();
        let signed = letters.iter().filter(|factor| factor.base_and_exponent().0 != of_scale);
        let signed = Expr::product(signed.cloned());
        let quotients = scaled.terms().iter().map(|term| Expr::divide(term, &common).ok());
        let quotient = Expr::sum(quotients.collect::<Option<Vec<Expr>>>()?);
        if number.is_zero() || quotient.symbols().into_iter().any(|name| name != a) {
            return None;
        }
        let function = CompiledFunction::new(&quotient, &[a]).ok()?;
        let value = |amplitude: f64| function.call(&[amplitude]);
        let grid: Vec<f64> = GRID.map(|k| 10.0_f64.powf(f64::from(k) / PER_DECADE)).collect();
        let cycle = |pair: &[f64]| {
            let (before, behind) = (value(pair[0]), value(pair[1]));
            let root =
                (before * behind < 0.0).then(|| find_root(value, pair[0], pair[1]).ok())??;
            let sign = Expr::from(if before > 0.0 { 1 } else { -1 });
            Some(LeadingCycle {
                amplitude: &scale * &Expr::number(rounded(root)),
                attracts_where: Some(sign * &signed),
            })
        };
        Some(grid.windows(2).filter_map(cycle).collect())
    })
}

/// A sum of powers of the amplitude: the exponents and their coefficients.
struct PowerLaw(Vec<(Expr, Expr)>);

impl PowerLaw {
    /// `None` if the amplitude stands elsewhere.
    fn from_rate(rate: &Expr, a: Symbol) -> Option<Self> {
        let mut law: Vec<(Expr, Expr)> = Vec::new();
        for term in rate.expand().ok()?.terms() {
            let (number, factors) = term.factors();
            let (mut exponent, mut coefficient) = (Expr::zero(), Expr::number(number));
            for factor in factors {
                let (base, power) = factor.base_and_exponent();
                if base.as_symbol() == Some(a) && !power.contains(a) {
                    exponent = exponent + power;
                } else if factor.contains(a) {
                    return None;
                } else {
                    coefficient = &coefficient * factor;
                }
            }
            let exponent = exponent.expand().ok()?;
            match law.iter_mut().find(|known| known.0 == exponent) {
                Some(known) => known.1 = (&known.1 + &coefficient).expand().ok()?,
                None => law.push((exponent, coefficient)),
            }
        }
        law.retain(|(_, coefficient)| !coefficient.is_zero());
        Some(Self(law))
    }

    /// `a(t)` and where it ends.
    fn solved(&self, start: &Expr) -> Option<(Expr, Option<Expr>)> {
        match self.0.as_slice() {
            [(exponent, c)] => of_one_power(exponent, c, start),
            [(p, c), (m, d)] if p.is_one() => bernoulli(c, m, d, start),
            [(m, d), (p, c)] if p.is_one() => bernoulli(c, m, d, start),
            [(p, c), (q, d)] | [(q, d), (p, c)] if p.is_zero() && *q == Expr::from(2) => {
                of_constant_and_square(c, d, start)
            }
            _ => None,
        }
    }

    /// `psi(t)`.
    fn phase(&self, rate: &Expr, a: Symbol, amplitude: &Expr, start: &Expr) -> Option<Expr> {
        let parts = Self::from_rate(rate, a)?;
        let mut sum = Vec::new();
        for (k, coefficient) in &parts.0 {
            let integral = self.integral(k, amplitude, start)?;
            // A product with a sum is not expanded: the terms that cancel at the start stay
            // together.
            sum.push(coefficient * &integral);
        }
        Some(Expr::sum(sum))
    }

    /// `int_0^t a^k dt`.
    fn integral(&self, k: &Expr, amplitude: &Expr, start: &Expr) -> Option<Expr> {
        if k.is_zero() {
            return Some(Expr::from(Symbol::new("t")));
        }
        // (a^j - A^j)/j, or log(a/A).
        let rise = |j: &Expr| {
            if j.is_zero() {
                let quotient = Expr::divide(amplitude, start).ok()?;
                return Expr::function(Function::Log, vec![quotient]).ok();
            }
            let difference = Expr::power(amplitude, j).ok()? - Expr::power(start, j).ok()?;
            Expr::divide(&difference, j).ok()
        };
        match self.0.as_slice() {
            [(n, c)] => {
                let j = (k - n + Expr::one()).expand().ok()?;
                Expr::divide(&rise(&j)?, c).ok()
            }
            [first, second] => {
                let (k, [p, q]) = (k.as_number()?, [first.0.as_number()?, second.0.as_number()?]);
                let ([(high, c), (low, d)], highest) = match p > q {
                    true => ([(p, &first.1), (q, &second.1)], p),
                    false => ([(q, &second.1), (p, &first.1)], q),
                };
                // The integral of a power is reduced to that of a lower one, down to one that is
                // known.
                let j = k - highest + Rational::one();
                if j.is_negative() {
                    return None;
                }
                let below = low + &j - Rational::one();
                if below.is_negative() || !(high - low).is_positive() {
                    return None;
                }
                let rise = rise(&Expr::number(j))?;
                let below = self.integral(&Expr::number(below), amplitude, start)?;
                Expr::divide(&(rise - d * &below), c).ok()
            }
            _ => None,
        }
    }
}

fn time() -> Expr {
    Expr::symbol("t")
}

fn exponential(rate: &Expr) -> Option<Expr> {
    let argument = (rate * &time()).expand().ok()?;
    Expr::function(Function::Exp, vec![argument]).ok()
}

/// `1/number`.
fn inverse(number: &Expr) -> Option<Expr> {
    Expr::divide(&Expr::one(), number).ok()
}

/// `a' = c a^n`.
fn of_one_power(n: &Expr, c: &Expr, start: &Expr) -> Option<(Expr, Option<Expr>)> {
    if n.is_one() {
        return Some((start * &exponential(c)?, None));
    }
    let below_one = n.as_number().is_some_and(|n| *n < Rational::one());
    if below_one {
        let rest = (Expr::one() - n).expand().ok()?;
        let begins = Expr::power(start, &rest).ok()?;
        let pace = (&rest * c).expand().ok()?;
        let amplitude = Expr::power(&(&begins + &(&pace * &time())), &inverse(&rest)?).ok()?;
        let ends = match pace.has_leading_minus() {
            true => Some(Expr::divide(&begins, &-&pace).ok()?),
            false => None,
        };
        return Some((amplitude, ends));
    }
    let excess = (n - &Expr::one()).expand().ok()?;
    let pace = (&(&excess * c) * &Expr::power(start, &excess).ok()?).expand().ok()?;
    let below = Expr::power(&(Expr::one() - &pace * &time()), &inverse(&excess)?).ok()?;
    let ends = match pace.has_leading_minus() {
        true => None,
        false => Some(inverse(&pace)?),
    };
    Some((Expr::divide(start, &below).ok()?, ends))
}

/// `a' = c a + d a^m`.
fn bernoulli(c: &Expr, m: &Expr, d: &Expr, start: &Expr) -> Option<(Expr, Option<Expr>)> {
    let quotient = Expr::divide(d, c).ok()?.expand().ok()?;
    let below_one = m.as_number().is_some_and(|m| *m < Rational::one());
    if below_one {
        let rest = (Expr::one() - m).expand().ok()?;
        let begins = Expr::power(start, &rest).ok()? + &quotient;
        let pace = (&rest * c).expand().ok()?;
        let power = &begins * &exponential(&pace)? - &quotient;
        let amplitude = Expr::power(&power, &inverse(&rest)?).ok()?;
        // Both drain: the power comes down to zero.
        let ends = match pace.has_leading_minus() && !quotient.has_leading_minus() {
            true => {
                let ratio = Expr::divide(&begins, &quotient).ok()?.expand().ok()?;
                let log = Expr::function(Function::Log, vec![ratio]).ok()?;
                Some(Expr::divide(&log, &-&pace).ok()?)
            }
            false => None,
        };
        return Some((amplitude, ends));
    }
    let excess = (m - &Expr::one()).expand().ok()?;
    let root = inverse(&excess)?;
    let pace = (&excess * c).expand().ok()?;
    let size = Expr::power(start, &excess).ok()?;
    if !c.has_leading_minus() && quotient.has_leading_minus() {
        // The motion tends to the amplitude at which both terms balance.
        let steady = inverse(&-&quotient)?;
        let fades = (Expr::divide(&steady, &size).ok()? - Expr::one()) * exponential(&-&pace)?;
        let below = Expr::power(&(Expr::one() + fades), &root).ok()?;
        let steady = Expr::power(&steady, &root).ok()?;
        return Some((Expr::divide(&steady, &below).ok()?, None));
    }
    let grows = (Expr::one() - exponential(&pace)?) * &(&quotient * &size);
    let below = Expr::power(&(Expr::one() + grows), &root).ok()?;
    Some((Expr::divide(&(start * &exponential(c)?), &below).ok()?, None))
}

/// `a' = c + d a^2` where both drain.
fn of_constant_and_square(c: &Expr, d: &Expr, start: &Expr) -> Option<(Expr, Option<Expr>)> {
    if !c.has_leading_minus() || !d.has_leading_minus() {
        return None;
    }
    let [c, d] = [-c, -d];
    let scale = Expr::divide(&c, &d).ok()?.sqrt().ok()?;
    let pace = (&c * &d).expand().ok()?.sqrt().ok()?;
    let angle = Expr::function(Function::Atan, vec![Expr::divide(start, &scale).ok()?]).ok()?;
    let moving = &angle - &(&pace * &time());
    let amplitude = &scale * &Expr::function(Function::Tan, vec![moving]).ok()?;
    Some((amplitude, Some(Expr::divide(&angle, &pace).ok()?)))
}

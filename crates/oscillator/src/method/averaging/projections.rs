//! The first harmonic of a term in coordinate and velocity along a harmonic motion, in closed form.
//!
//! References: NIST Digital Library of Mathematical Functions 5.12.2 (the Beta integral); N. N.
//! Bogoliubov, Y. A. Mitropolsky, *Asymptotic Methods in the Theory of Non-Linear Oscillations*,
//! Gordon and Breach 1961, section 1.
//!
//! ```text
//! x = a cos(psi), v = -b sin(psi), b = a omega0
//! S = (1/pi) int_0^(2 pi) h(x, v) sin(psi) dpsi,      C = (1/pi) int_0^(2 pi) h(x, v) cos(psi) dpsi
//! h = |x|^p |v|^q sgn(v):   S = -(2/pi) a^p b^q Gamma((p+1)/2) Gamma((q+2)/2)/Gamma((p+q+3)/2)
//! h = |x|^p sgn(x) |v|^q:   C =  (2/pi) a^p b^q Gamma((p+2)/2) Gamma((q+1)/2)/Gamma((p+q+3)/2)
//! h = x^p V(v), p even:     S = -a^p c_1[V(y) (1 - (y/b)^2)^(p/2)]
//! h = x^p V(v), p odd:      C =  a^p c_0[V(y) (1 - (y/b)^2)^((p+1)/2)]
//! h = X(x) v^q, q odd:      S = -b^q c_0[X (1 - (x/a)^2)^((q+1)/2)]
//! h = X(x) v^q, q even:     C =  b^q c_1[X (1 - (x/a)^2)^(q/2)]
//! ```
//!
//! and, for the arctangent that stands for dry friction,
//!
//! ```text
//! atan(z cos) = 2 sum_m (-1)^m r^(2m+1)/(2m+1) cos((2m+1) .),     r = (sqrt(1 + z^2) - 1)/z
//! ```
//!
//! with `c_k` of [`conservative`](crate::conservative): a force of the velocity is one of the
//! position a quarter of a period later.

use num_integer::Integer as _;

use crate::conservative::power::Power;
use crate::conservative::{cosine_coefficient, linear_in, split};
use crate::exact::Rational;
use crate::exact::rational::ratio;
use crate::expr::{Expr, Function, Node};
use crate::symbol::Symbol;

/// `[S, C]` of a term; `None` if one has no closed form here.
pub(super) fn of_term(
    term: &Expr,
    coordinate: Symbol,
    amplitude: &Expr,
    omega0: &Expr,
) -> Option<[Expr; 2]> {
    let velocity = coordinate.derivative();
    let speed = amplitude * omega0;
    let (number, factors) = term.factors();
    let mut outside = Expr::number(number);
    let [mut of_position, mut of_velocity] = [Power::one(), Power::one()];
    let [mut positions, mut velocities] = [vec![], vec![]];
    for factor in factors {
        let both = [coordinate, velocity].map(|name| factor.contains(name));
        match both {
            [false, false] => outside = &outside * factor,
            [true, true] => return None,
            [true, false] if of_position.absorb(factor, coordinate) => {}
            [false, true] if of_velocity.absorb(factor, velocity) => {}
            [true, false] => positions.push(factor.clone()),
            [false, true] => velocities.push(factor.clone()),
        }
    }
    let [sine, cosine] = match (positions.is_empty(), velocities.is_empty()) {
        (true, true) => of_powers(&of_position, &of_velocity, amplitude, &speed)?,
        (true, false) => of_velocity_beside_power(
            &(Expr::product(velocities) * of_velocity.in_terms_of(velocity)?),
            &of_position,
            velocity,
            amplitude,
            &speed,
        )?,
        (false, true) => of_position_beside_power(
            &(Expr::product(positions) * of_position.in_terms_of(coordinate)?),
            &of_velocity,
            coordinate,
            amplitude,
            &speed,
        )?,
        (false, false) => return None,
    };
    Some([(&outside * &sine).expand().ok()?, (&outside * &cosine).expand().ok()?])
}

/// Powers of both, by the Beta integral.
fn of_powers(
    position: &Power,
    velocity: &Power,
    amplitude: &Expr,
    speed: &Expr,
) -> Option<[Expr; 2]> {
    let zero = || Some([Expr::zero(), Expr::zero()]);
    let (above_position, above_velocity) = match (position.odd, velocity.odd) {
        (false, true) => (1, 2),
        (true, false) => (2, 1),
        _ => return zero(),
    };
    // The integrals exist where the arguments of the Gamma functions in the numerator are positive.
    for (exponent, above) in
        [(&position.exponent, above_position), (&velocity.exponent, above_velocity)]
    {
        if exponent.as_number().is_some_and(|number| *number <= ratio(-above, 1)) {
            return None;
        }
    }
    let half_of = |sum: Expr| (&Expr::number(ratio(1, 2)) * &sum).expand().ok();
    let gamma = |argument: Expr| Expr::function(Function::Gamma, vec![argument]).ok();
    let numerator = gamma(half_of(&position.exponent + &Expr::from(above_position))?)?
        * gamma(half_of(&velocity.exponent + &Expr::from(above_velocity))?)?;
    let denominator = gamma(half_of(&position.exponent + &velocity.exponent + Expr::from(3))?)?;
    let sizes = Expr::power(amplitude, &position.exponent).ok()?
        * power_of_product(speed, &velocity.exponent)?;
    let value = Expr::divide(&(numerator * sizes), &(denominator * Expr::pi())).ok()?;
    let value = (Expr::from(2) * value).expand().ok()?;
    Some(match velocity.odd {
        true => [-value, Expr::zero()],
        false => [Expr::zero(), value],
    })
}

/// The power of a product of positive factors, taken factor by factor, so that powers of the
/// amplitude are separate.
fn power_of_product(product: &Expr, exponent: &Expr) -> Option<Expr> {
    let (number, factors) = product.factors();
    let number = Expr::power(&Expr::number(number), exponent).ok()?;
    let mut power = number;
    for factor in factors {
        let (base, inner) = factor.base_and_exponent();
        power = power * Expr::power(&base, &(&inner * exponent).expand().ok()?).ok()?;
    }
    Some(power)
}

/// A function of the velocity times a whole power of the coordinate.
fn of_velocity_beside_power(
    function: &Expr,
    position: &Power,
    velocity: Symbol,
    amplitude: &Expr,
    speed: &Expr,
) -> Option<[Expr; 2]> {
    let p = position.integer_exponent()?;
    let (k, halves) = if p.is_even() { (1, p / 2) } else { (0, p / 2 + 1) };
    let value = projected(function, halves, velocity, speed, k)?
        * amplitude.integer_power(p as i64).ok()?;
    Some(match k {
        1 => [-value, Expr::zero()],
        _ => [Expr::zero(), value],
    })
}

/// A function of the coordinate times a whole power of the velocity.
fn of_position_beside_power(
    function: &Expr,
    velocity: &Power,
    coordinate: Symbol,
    amplitude: &Expr,
    speed: &Expr,
) -> Option<[Expr; 2]> {
    let q = velocity.integer_exponent()?;
    let (k, halves) = if q.is_even() { (1, q / 2) } else { (0, q / 2 + 1) };
    let value = projected(function, halves, coordinate, amplitude, k)?
        * speed.integer_power(q as i64).ok()?;
    Some(match k {
        1 => [Expr::zero(), value],
        _ => [-value, Expr::zero()],
    })
}

/// `c_k` of `function * (1 - (y/size)^2)^halves` along `size * cos`.
fn projected(
    function: &Expr,
    halves: usize,
    variable: Symbol,
    size: &Expr,
    k: usize,
) -> Option<Expr> {
    let mut binomial = Rational::from_integer(1.into());
    let mut sum = Vec::new();
    for j in 0..=halves {
        let power = Expr::from(variable).integer_power(2 * j as i64).ok()?;
        let product = function * &power;
        let coefficient = cosine_coefficient(&product, variable, size, k)
            .or_else(|| arctangent_coefficient(&product, variable, size, k))?;
        let scale =
            Expr::divide(&Expr::number(binomial.clone()), &size.integer_power(2 * j as i64).ok()?)
                .ok()?;
        sum.push(&scale * &coefficient);
        let [next, below] = [halves - j, j + 1].map(|n| Rational::from_integer(n.into()));
        binomial = -(binomial * next / below);
    }
    // A projection may leave the coordinate in a factor that it cannot resolve.
    let value = Expr::sum(sum).expand().ok()?;
    let (_, inside) = split(&value, variable);
    inside.is_empty().then_some(value)
}

/// `c_k` of a whole power times an arctangent of a multiple of the variable.
fn arctangent_coefficient(product: &Expr, variable: Symbol, size: &Expr, k: usize) -> Option<Expr> {
    let (number, factors) = product.factors();
    let (mut outside, mut power, mut slope) = (Expr::number(number), Power::one(), None);
    for factor in factors {
        match factor.node() {
            Node::Function(Function::Atan, arguments)
                if slope.is_none() && factor.contains(variable) =>
            {
                let (found, constant) = linear_in(&arguments[0], variable)?;
                slope = constant.is_zero().then_some(found);
                slope.as_ref()?;
            }
            _ if !factor.contains(variable) => outside = &outside * factor,
            _ if power.absorb(factor, variable) => {}
            _ => return None,
        }
    }
    let (count, z) = (power.integer_exponent()?, slope? * size);
    let root = (Expr::one() + z.integer_power(2).ok()?).sqrt().ok()?;
    let r = Expr::divide(&(root - Expr::one()), &z).ok()?;
    // cos^n cos(k .) = 2^-n sum_i binomial(n, i) cos((k + n - 2 i) .)
    let mut binomial = Rational::from_integer(1.into());
    let mut sum = Vec::new();
    for i in 0..=count {
        let harmonic = (k + count).abs_diff(2 * i);
        if harmonic.is_odd() {
            let sign = if (harmonic / 2).is_odd() { -2 } else { 2 };
            let scale = &binomial * ratio(sign, harmonic as i64);
            sum.push(Expr::number(scale) * r.integer_power(harmonic as i64).ok()?);
        }
        let [next, below] = [count - i, i + 1].map(|n| Rational::from_integer(n.into()));
        binomial = binomial * next / below;
    }
    let halves = Expr::number(num_traits::pow(ratio(1, 2), count));
    Some(outside * halves * Expr::sum(sum) * size.integer_power(count as i64).ok()?)
}

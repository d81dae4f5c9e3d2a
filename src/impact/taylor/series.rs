//! The motion as a power series about the present moment: free flight in time, contact in a variable of its own.
//!
//! ```text
//! flight:   x' = v,  v' = -2 zeta v - sin x - friction + beta sin(eta t) cos x,       derivatives by t
//! contact:  x = x_r + w^2,  dt = w ds:                                               derivatives by s
//!           w' = v/2,  t' = w,
//!           v' = -w (sin x + friction - beta sin(eta t) cos x) - 2 zeta w v - (gamma + mu v) w^4
//! products: (a b)_n = sum_k a_k b_(n-k);   u = sin x, c = cos x:  n u_n = sum_k k x_k c_(n-k);   (w^2)' = w v
//!           y = 1 + k^2 v^2, p = atan(k v):  n p_n y_0 = k n v_n - sum_(0<j<n) j p_j y_(n-j)
//! ```
//!
//! In time the contact force (x - x_r)^(3/2) is not analytic at the touch; in s it is a polynomial in w, and touch and
//! release are simple zeros of w, however slow the touch. (The recurrences: A. Jorba and M. Zou, *Experimental Math.*
//! 14 (2005) 99; the change of variable is that of Levi-Civita and Sundman for collisions.) A left barrier is a right
//! one seen in a mirror: x, v, beta and the direction of friction change sign.
//!
//! Times are counted in a unit of choice, so that no coefficient over- or underflows, and stretched within a step (`stretch`). `L` motions go through the same
//! operations side by side; each gets bit for bit what it would get alone.

use super::angle::sines_and_cosines;
use super::stretch::{in_contact, in_flight, stretched};
use super::{Equation, Loaded};
use crate::impact::model::STEEPNESS;
use crate::impact::polynomial::lanes::{values, values_of, variations};

/// Highest order of a series.
pub(super) const HIGHEST_ORDER: usize = 30;

/// Coefficients of the time in flight.
pub(super) const TIME_TERMS: usize = 4;

/// How many of the last coefficients decide on the length of a step: a series may have gaps. At touch v is a series in
/// s^5, for v' = -gamma w^4 and w' = v/2.
pub(super) const LAST: usize = 5;

/// Coefficients of a series, those of `L` motions side by side.
pub(super) type Series<const L: usize> = [[f64; L]; HIGHEST_ORDER + 1];

/// Which terms of equation (7) are on in at least one of the motions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Terms {
    pub(super) arctangent: bool,
    pub(super) excited: bool,
    pub(super) damped_contact: bool,
}

impl Terms {
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            arctangent: self.arctangent || other.arctangent,
            excited: self.excited || other.excited,
            damped_contact: self.damped_contact || other.damped_contact,
        }
    }
}

/// What the series of `L` motions start from: where they are now, and their parameters. In contact everything is seen in the mirror of its side.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(super) struct Inputs<const L: usize> {
    /// x in flight, w = sqrt(x - x_r) in contact.
    pub(super) place: [f64; L],
    pub(super) velocity: [f64; L],
    /// In contact: the barrier; otherwise 0.
    pub(super) base: [f64; L],
    pub(super) sine: [f64; L],
    pub(super) cosine: [f64; L],
    /// sin and cos of eta t.
    pub(super) drive: [[f64; L]; 2],
    /// The unit of t, or of s.
    pub(super) unit: [f64; L],
    /// In contact: the largest w and the largest speed of Hertz's contact that began so.
    pub(super) hertz: [[f64; L]; 2],
    /// Coulomb's friction, alpha times the direction of motion.
    pub(super) dry: [f64; L],
    /// (2/pi) alpha in equation (6).
    pub(super) arctangent: [f64; L],
    pub(super) viscous: [f64; L],
    pub(super) beta: [f64; L],
    pub(super) eta: [f64; L],
    pub(super) gamma: [f64; L],
    pub(super) mu: [f64; L],
    /// How large the motion is, and what the first term left out of a step may be.
    pub(super) size: [f64; L],
    pub(super) allowed: [f64; L],
    /// Between which x or w stays in this phase.
    pub(super) lower: [f64; L],
    pub(super) upper: [f64; L],
}

impl<const L: usize> Inputs<L> {
    pub(super) fn new() -> Self {
        let zero = [0.0; L];
        Self {
            place: zero,
            velocity: zero,
            base: zero,
            sine: zero,
            cosine: zero,
            drive: [zero; 2],
            unit: zero,
            hertz: [[1.0; L]; 2],
            dry: zero,
            arctangent: zero,
            viscous: zero,
            beta: zero,
            eta: zero,
            gamma: zero,
            mu: zero,
            size: zero,
            allowed: zero,
            lower: zero,
            upper: zero,
        }
    }
}

/// What a step is made of: two or three series, all but the first two scratch outside contact. No coefficient of eight lanes lies
/// across two lines of the cache.
#[repr(align(64))]
pub(super) struct Coefficients<const L: usize> {
    /// x in flight, w in contact.
    pub(super) place: Series<L>,
    pub(super) velocity: Series<L>,
    /// Time since the start of the step.
    pub(super) time: Series<L>,
    sine: Series<L>,
    cosine: Series<L>,
    drive: [Series<L>; 2],
    phase_rate: Series<L>,
    square: Series<L>,
    angle: Series<L>,
    rate: Series<L>,
    depth: Series<L>,
    fourth: Series<L>,
    slow: Series<L>,
    ahead: Ahead<L>,
}

impl<const L: usize> Coefficients<L> {
    pub(super) fn new() -> Self {
        let zero = [[0.0; L]; HIGHEST_ORDER + 1];
        Self {
            place: zero,
            velocity: zero,
            time: zero,
            sine: zero,
            cosine: zero,
            drive: [zero; 2],
            phase_rate: zero,
            square: zero,
            angle: zero,
            rate: zero,
            depth: zero,
            fourth: zero,
            slow: zero,
            ahead: Ahead::new(),
        }
    }
}

/// What is known of each product (a b)_(n+1) as soon as (a b)_n is: all but a_0 b_(n+1) and a_(n+1) b_0.
#[derive(Debug, Clone, Copy)]
struct Ahead<const L: usize> {
    angle: [[f64; L]; 2],
    phase: [[f64; L]; 2],
    push: [f64; L],
    speed: [f64; L],
    depth: [f64; L],
    fourth: [f64; L],
    carried: [f64; L],
    damped: [f64; L],
}

impl<const L: usize> Ahead<L> {
    fn new() -> Self {
        let zero = [0.0; L];
        Self {
            angle: [zero; 2],
            phase: [zero; 2],
            push: zero,
            speed: zero,
            depth: zero,
            fourth: zero,
            carried: zero,
            damped: zero,
        }
    }
}

/// The values of the series at the end of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends<const L: usize> {
    pub(super) place: [f64; L],
    pub(super) velocity: [f64; L],
    pub(super) time: [f64; L],
    pub(super) variation: [f64; L],
    pub(super) sine: [f64; L],
    pub(super) cosine: [f64; L],
}

/// Those of one motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct End {
    pub(super) place: f64,
    pub(super) velocity: f64,
    /// The time that the step takes.
    pub(super) time: f64,
    /// A bound on the change of the velocity within the step.
    pub(super) variation: f64,
    /// Of x, in contact as seen in the mirror.
    pub(super) sine: f64,
    pub(super) cosine: f64,
}

impl<const L: usize> Ends<L> {
    pub(super) fn new() -> Self {
        let zero = [0.0; L];
        Self {
            place: zero,
            velocity: zero,
            time: zero,
            variation: zero,
            sine: zero,
            cosine: zero,
        }
    }

    pub(super) fn lane(&self, lane: usize) -> End {
        End {
            place: self.place[lane],
            velocity: self.velocity[lane],
            time: self.time[lane],
            variation: self.variation[lane],
            sine: self.sine[lane],
            cosine: self.cosine[lane],
        }
    }
}

impl<const L: usize> Coefficients<L> {
    /// The series of one motion: x or w, v, t.
    pub(super) fn lane(&self, order: usize, lane: usize) -> Loaded {
        let mut own = [[0.0; HIGHEST_ORDER + 1]; 3];
        for (own, all) in own.iter_mut().zip([&self.place, &self.velocity, &self.time]) {
            for (coefficient, lanes) in own.iter_mut().zip(all).take(order + 1) {
                *coefficient = lanes[lane];
            }
        }
        own
    }

    /// Place, velocity and time at these points; the time is a short polynomial in flight.
    #[inline(always)]
    pub(super) fn values(&self, at: &[f64; L], order: usize, equation: Equation) -> [[f64; L]; 3] {
        let order = order.min(HIGHEST_ORDER);
        let (place, velocity) = (&self.place[..=order], &self.velocity[..=order]);
        match equation {
            Equation::Flight => {
                let [place, velocity] = values_of([place, velocity], at);
                [place, velocity, values(&self.time[..TIME_TERMS], at)]
            }
            Equation::Contact => values_of([place, velocity, &self.time[..=order]], at),
        }
    }

    /// The values of the series where the steps end.
    #[inline(always)]
    pub(super) fn ends(&self, inputs: &Inputs<L>, lengths: &[f64; L], order: usize, equation: Equation) -> Ends<L> {
        let order = order.min(HIGHEST_ORDER);
        let [place, velocity, time] = self.values(lengths, order, equation);
        let angle = match equation {
            Equation::Flight => place,
            Equation::Contact => each(|lane| inputs.base[lane] + place[lane] * place[lane]),
        };
        let (sine, cosine) = sines_and_cosines(&angle);
        Ends {
            place,
            velocity,
            time,
            variation: variations(&self.velocity[..=order], lengths),
            sine,
            cosine,
        }
    }
}

/// Motions in one register of 256 bits.
const REGISTER: usize = 4;

/// (a b)_n, asked for in rising order: an even n is computed together with what is known of the next, so that every coefficient is
/// read once for both.
#[inline(always)]
fn product<const L: usize>(a: &Series<L>, b: &Series<L>, n: usize, ahead: &mut [f64; L]) -> [f64; L] {
    let mut sum = [0.0; L];
    if n % 2 == 1 {
        for lane in 0..L {
            sum[lane] = ahead[lane] + a[0][lane] * b[n][lane] + a[n][lane] * b[0][lane];
        }
        return sum;
    }
    let mut next = [0.0; L];
    for ((low, high), b) in a[..n].iter().zip(&a[1..=n]).zip(b[1..=n].iter().rev()) {
        for lane in 0..L {
            sum[lane] += low[lane] * b[lane];
            next[lane] += high[lane] * b[lane];
        }
    }
    for lane in 0..L {
        sum[lane] += a[n][lane] * b[0][lane];
    }
    *ahead = next;
    sum
}

/// (a b)_n and (a c)_n likewise.
#[inline(always)]
fn products<const L: usize>(
    a: &Series<L>,
    [b, c]: [&Series<L>; 2],
    n: usize,
    ahead: &mut [[f64; L]; 2],
) -> [[f64; L]; 2] {
    let mut sums = [[0.0; L]; 2];
    if n % 2 == 1 {
        for lane in 0..L {
            sums[0][lane] = ahead[0][lane] + a[0][lane] * b[n][lane] + a[n][lane] * b[0][lane];
            sums[1][lane] = ahead[1][lane] + a[0][lane] * c[n][lane] + a[n][lane] * c[0][lane];
        }
        return sums;
    }
    let mut next = [[0.0; L]; 2];
    for ((low, high), (b, c)) in a[..n].iter().zip(&a[1..=n]).zip(b[1..=n].iter().zip(&c[1..=n]).rev()) {
        // A register at a time: so that the sums stay in theirs.
        for first in (0..L).step_by(REGISTER) {
            let last = L.min(first + REGISTER);
            for lane in first..last {
                sums[0][lane] += low[lane] * b[lane];
                next[0][lane] += high[lane] * b[lane];
            }
            for lane in first..last {
                sums[1][lane] += low[lane] * c[lane];
                next[1][lane] += high[lane] * c[lane];
            }
        }
    }
    for lane in 0..L {
        sums[0][lane] += a[n][lane] * b[0][lane];
        sums[1][lane] += a[n][lane] * c[0][lane];
    }
    *ahead = next;
    sums
}

/// (a b)_n likewise where one is the other times a constant: half the terms are like the other half.
#[inline(always)]
fn symmetric<const L: usize>(a: &Series<L>, b: &Series<L>, n: usize, ahead: &mut [f64; L]) -> [f64; L] {
    let mut sum = [0.0; L];
    let half = n / 2;
    if n % 2 == 1 {
        for lane in 0..L {
            sum[lane] = 2.0 * (ahead[lane] + a[0][lane] * b[n][lane]);
        }
        return sum;
    }
    let mut next = [0.0; L];
    if half > 0 {
        let falling = b[half + 1..=n].iter().rev();
        for (a, (high, low)) in a[1..=half].iter().zip(falling.zip(b[half..n].iter().rev())) {
            for lane in 0..L {
                next[lane] += a[lane] * high[lane];
                sum[lane] += a[lane] * low[lane];
            }
        }
        // The middle one, which stands alone, came last.
        for lane in 0..L {
            sum[lane] = 2.0 * (sum[lane] + a[0][lane] * b[n][lane]) - a[half][lane] * b[half][lane];
        }
    } else {
        for lane in 0..L {
            sum[lane] = a[0][lane] * b[0][lane];
        }
    }
    *ahead = next;
    sum
}

/// (a a)_n.
#[inline(always)]
fn square<const L: usize>(a: &Series<L>, n: usize, ahead: &mut [f64; L]) -> [f64; L] {
    symmetric(a, a, n, ahead)
}

#[inline(always)]
fn each<const L: usize>(value: impl Fn(usize) -> f64) -> [f64; L] {
    let mut result = [0.0; L];
    for (lane, entry) in result.iter_mut().enumerate() {
        *entry = value(lane);
    }
    result
}

/// 1/n.
pub(super) const INVERSE: [f64; HIGHEST_ORDER + 2] = {
    let mut table = [0.0; HIGHEST_ORDER + 2];
    let mut n = 1;
    while n < table.len() {
        table[n] = 1.0 / n as f64;
        n += 1;
    }
    table
};

/// The next coefficients of sine and cosine of an angle with this rate: n s_n = (rate c)_(n-1).
#[inline(always)]
fn sine_and_cosine<const L: usize>(
    [sine, cosine]: [&mut Series<L>; 2],
    rate: &Series<L>,
    n: usize,
    ahead: &mut [[f64; L]; 2],
) {
    let [up, down] = products(rate, [cosine, sine], n - 1, ahead);
    for lane in 0..L {
        sine[n][lane] = INVERSE[n] * up[lane];
        cosine[n][lane] = -INVERSE[n] * down[lane];
    }
}

/// The next coefficient of atan(k v).
#[inline(always)]
fn arctangent<const L: usize>(
    [angle, squares]: [&mut Series<L>; 2],
    velocity: &Series<L>,
    n: usize,
    ahead: &mut [f64; L],
) {
    let steepness_squared = STEEPNESS * STEEPNESS;
    let squared = square(velocity, n, ahead);
    if n == 0 {
        squares[0] = each(|lane| 1.0 + steepness_squared * squared[lane]);
        angle[0] = each(|lane| (STEEPNESS * velocity[0][lane]).atan());
        return;
    }
    squares[n] = each(|lane| steepness_squared * squared[lane]);
    let mut sum = [0.0; L];
    for j in 1..n {
        for lane in 0..L {
            sum[lane] += j as f64 * angle[j][lane] * squares[n - j][lane];
        }
    }
    angle[n] = each(|lane| (STEEPNESS * velocity[n][lane] - INVERSE[n] * sum[lane]) / squares[0][lane]);
}

/// The series of free motion to this order.
#[inline(always)]
pub(super) fn flight<const L: usize>(inputs: &Inputs<L>, order: usize, terms: Terms, series: &mut Coefficients<L>) {
    let order = order.min(HIGHEST_ORDER);
    series.place[0] = inputs.place;
    series.velocity[0] = inputs.velocity;
    series.sine[0] = inputs.sine;
    series.cosine[0] = inputs.cosine;
    if terms.excited {
        for part in 0..2 {
            series.drive[part][0] = inputs.drive[part];
        }
    }
    // t = unit (r + p r^2/2 + q r^3/3).
    let stretch = in_flight(inputs);
    series.time[0] = [0.0; L];
    series.time[1] = inputs.unit;
    series.time[2] = each(|lane| 0.5 * inputs.unit[lane] * stretch[0][lane]);
    series.time[3] = each(|lane| INVERSE[3] * inputs.unit[lane] * stretch[1][lane]);
    series.ahead = Ahead::new();
    let mut forces = [[0.0; L]; 2];
    for n in 0..order {
        let factor: [f64; L] = each(|lane| inputs.unit[lane] * INVERSE[n + 1]);
        let velocity = stretched(&stretch, &series.velocity, n);
        series.rate[n] = each(|lane| inputs.unit[lane] * velocity[lane]);
        series.place[n + 1] = each(|lane| INVERSE[n + 1] * series.rate[n][lane]);
        if n > 0 {
            sine_and_cosine(
                [&mut series.sine, &mut series.cosine],
                &series.rate,
                n,
                &mut series.ahead.angle,
            );
        }
        let mut force: [f64; L] = each(|lane| -inputs.viscous[lane] * series.velocity[n][lane] - series.sine[n][lane]);
        if n == 0 {
            force = each(|lane| force[lane] - inputs.dry[lane]);
        }
        if terms.arctangent {
            arctangent(
                [&mut series.angle, &mut series.square],
                &series.velocity,
                n,
                &mut series.ahead.speed,
            );
            force = each(|lane| force[lane] - inputs.arctangent[lane] * series.angle[n][lane]);
        }
        if terms.excited {
            if n > 0 {
                // sin(eta t) and cos(eta t), each the derivative of the other.
                let cosine = stretched(&stretch, &series.drive[1], n - 1);
                let sine = stretched(&stretch, &series.drive[0], n - 1);
                let factor: [f64; L] = each(|lane| inputs.unit[lane] * inputs.eta[lane] * INVERSE[n]);
                series.drive[0][n] = each(|lane| factor[lane] * cosine[lane]);
                series.drive[1][n] = each(|lane| -factor[lane] * sine[lane]);
            }
            let push = product(&series.drive[0], &series.cosine, n, &mut series.ahead.push);
            force = each(|lane| force[lane] + inputs.beta[lane] * push[lane]);
        }
        let [p, q] = &stretch;
        let [before, earlier] = forces;
        let bent: [f64; L] = each(|lane| force[lane] + (p[lane] * before[lane] + q[lane] * earlier[lane]));
        series.velocity[n + 1] = each(|lane| factor[lane] * bent[lane]);
        forces = [force, before];
    }
}

/// The series of motion in contact to this order, in s.
#[inline(always)]
pub(super) fn contact<const L: usize>(inputs: &Inputs<L>, order: usize, terms: Terms, series: &mut Coefficients<L>) {
    let order = order.min(HIGHEST_ORDER);
    series.place[0] = inputs.place;
    series.velocity[0] = inputs.velocity;
    series.time[0] = [0.0; L];
    series.sine[0] = inputs.sine;
    series.cosine[0] = inputs.cosine;
    series.depth[0] = each(|lane| inputs.place[lane] * inputs.place[lane]);
    if terms.excited {
        for part in 0..2 {
            series.drive[part][0] = inputs.drive[part];
        }
    }
    series.ahead = Ahead::new();
    let stretch = in_contact(inputs);
    let mut forces = [[0.0; L]; 2];
    for n in 0..order {
        let factor: [f64; L] = each(|lane| inputs.unit[lane] * INVERSE[n + 1]);
        let place = stretched(&stretch, &series.place, n);
        series.time[n + 1] = each(|lane| factor[lane] * place[lane]);
        let velocity = stretched(&stretch, &series.velocity, n);
        series.place[n + 1] = each(|lane| 0.5 * factor[lane] * velocity[lane]);
        series.depth[n + 1] = square(&series.place, n + 1, &mut series.ahead.depth);
        series.rate[n] = each(|lane| (n + 1) as f64 * series.depth[n + 1][lane]);
        if n > 0 {
            sine_and_cosine(
                [&mut series.sine, &mut series.cosine],
                &series.rate,
                n,
                &mut series.ahead.angle,
            );
        }
        series.fourth[n] = square(&series.depth, n, &mut series.ahead.fourth);
        let mut slow = series.sine[n];
        if n == 0 {
            slow = each(|lane| slow[lane] + inputs.dry[lane]);
        }
        if terms.arctangent {
            arctangent(
                [&mut series.angle, &mut series.square],
                &series.velocity,
                n,
                &mut series.ahead.speed,
            );
            slow = each(|lane| slow[lane] + inputs.arctangent[lane] * series.angle[n][lane]);
        }
        if terms.excited {
            series.phase_rate[n] = each(|lane| (n + 1) as f64 * inputs.eta[lane] * series.time[n + 1][lane]);
            if n > 0 {
                let [sine, cosine] = &mut series.drive;
                sine_and_cosine([sine, cosine], &series.phase_rate, n, &mut series.ahead.phase);
            }
            let driven = product(&series.drive[0], &series.cosine, n, &mut series.ahead.push);
            slow = each(|lane| slow[lane] - inputs.beta[lane] * driven[lane]);
        }
        series.slow[n] = slow;
        let carried = product(&series.place, &series.slow, n, &mut series.ahead.carried);
        let mut force: [f64; L] = each(|lane| -carried[lane] - inputs.gamma[lane] * series.fourth[n][lane]);
        if terms.damped_contact {
            let damped = product(&series.velocity, &series.fourth, n, &mut series.ahead.damped);
            force = each(|lane| force[lane] - inputs.mu[lane] * damped[lane]);
        }
        let [p, q] = &stretch;
        let [before, earlier] = forces;
        let bent: [f64; L] = each(|lane| force[lane] + (p[lane] * before[lane] + q[lane] * earlier[lane]));
        series.velocity[n + 1] =
            each(|lane| factor[lane] * bent[lane] - inputs.viscous[lane] * series.depth[n + 1][lane]);
        forces = [force, before];
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::expr::parse_expression;
    use crate::series::recurrence::Recurrences;
    use crate::symbol::Symbol;

    const ORDER: usize = 24;

    /// A start with every force on, which the terms of a test switch off.
    fn inputs(terms: Terms) -> Inputs<1> {
        let on = |on: bool, value: f64| [if on { value } else { 0.0 }];
        let angle = 0.4_f64 + 0.3 * 0.3;
        let (sine, cosine) = (1.3_f64 * 0.7).sin_cos();
        Inputs {
            place: [0.3],
            velocity: [0.02],
            sine: [angle.sin()],
            cosine: [angle.cos()],
            drive: [[sine], [cosine]],
            unit: [0.01],
            hertz: [[0.35], [30.0]],
            dry: [0.05],
            arctangent: on(terms.arctangent, 0.11),
            viscous: [0.2],
            beta: on(terms.excited, 0.6),
            eta: [1.3],
            gamma: [500.0],
            mu: on(terms.damped_contact, 70.0),
            ..Inputs::new()
        }
    }

    /// The series of a system of equations as written, by the recurrences of their expressions: state by state.
    fn by_expressions(
        states: &[(&str, f64)],
        rates: &[&str],
        (inputs, [[p], [q]]): (&Inputs<1>, [[f64; 1]; 2]),
    ) -> Vec<Vec<f64>> {
        // r is counted in units, as the other series are.
        let unit = inputs.unit[0];
        let number = |name: &str, value: [f64; 1]| (Symbol::from(name), value[0]);
        let numbers = BTreeMap::from([
            number("dry", inputs.dry),
            number("arctangent", inputs.arctangent),
            number("viscous", inputs.viscous),
            number("beta", inputs.beta),
            number("eta", inputs.eta),
            number("gamma", inputs.gamma),
            number("mu", inputs.mu),
            number("x_r", [0.4]),
            number("k", [STEEPNESS]),
            number("p", [p / unit]),
            number("q", [q / (unit * unit)]),
        ]);
        let variables: Vec<(Symbol, Option<usize>)> =
            states.iter().map(|(name, _)| (Symbol::from(*name), None)).collect();
        let mut recurrences = Recurrences::new(&variables, &numbers, ORDER);
        let rates: Vec<usize> = rates
            .iter()
            .map(|text| recurrences.add(&parse_expression(text).expect(text)).expect(text))
            .collect();
        let mut tape = recurrences.into_tape();
        for (place, (_, value)) in states.iter().enumerate() {
            tape.set(place, 0, *value);
        }
        for order in 0..ORDER {
            tape.compute(order);
            for (place, rate) in rates.iter().enumerate() {
                tape.feed(place, *rate, order, inputs.unit[0]);
            }
        }
        (0..states.len()).map(|place| tape.series(place).to_vec()).collect()
    }

    fn assert_same(own: &Series<1>, other: &[f64], what: &str) {
        let size = other.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        for (n, (own, other)) in own.iter().zip(other).enumerate() {
            assert!(
                (own[0] - other).abs() <= 1e-13 * (other.abs() + 1e-3 * size),
                "{what}, order {n}: {} and {other}",
                own[0]
            );
        }
    }

    /// What stands in this file by hand is what follows from the equations of its head as expressions, coefficient by coefficient.
    #[test]
    fn the_series_are_those_of_the_expressions() {
        for bits in 0..8 {
            let terms = Terms {
                arctangent: bits & 1 != 0,
                excited: bits & 2 != 0,
                damped_contact: bits & 4 != 0,
            };
            let mut now = inputs(terms);
            let mut series = Coefficients::<1>::new();
            contact(&now, ORDER, terms, &mut series);
            let other = by_expressions(
                &[("w", 0.3), ("v", 0.02), ("t", 0.7), ("r", 0.0)],
                &[
                    "(1 + p*r + q*r^2)*v/2",
                    "(1 + p*r + q*r^2)*(-w*(sin(x_r + w^2) + dry + arctangent*atan(k*v) - beta*sin(eta*t)*cos(x_r + w^2)) \
                     - viscous*w*v - (gamma + mu*v)*w^4)",
                    "(1 + p*r + q*r^2)*w",
                    "1",
                ],
                (&now, in_contact(&now)),
            );
            assert_same(&series.place, &other[0], "w");
            assert_same(&series.velocity, &other[1], "v in contact");
            assert_same(&series.time, &[&[0.0], &other[2][1..]].concat(), "t");
            let x = 0.4 + 0.3 * 0.3;
            now.place = [x];
            flight(&now, ORDER, terms, &mut series);
            let other = by_expressions(
                &[("x", x), ("v", 0.02), ("t", 0.7), ("r", 0.0)],
                &[
                    "(1 + p*r + q*r^2)*v",
                    "(1 + p*r + q*r^2)*(-viscous*v - sin(x) - dry - arctangent*atan(k*v) + beta*sin(eta*t)*cos(x))",
                    "1 + p*r + q*r^2",
                    "1",
                ],
                (&now, in_flight(&now)),
            );
            assert_same(
                &series.time,
                &[&[0.0], &other[2][1..TIME_TERMS]].concat(),
                "t in flight",
            );
            assert_same(&series.place, &other[0], "x");
            assert_same(&series.velocity, &other[1], "v in flight");
        }
    }
}

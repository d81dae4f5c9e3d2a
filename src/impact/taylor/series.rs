//! The motion as a power series about the present moment: free flight in time, contact in a variable of its own.
//!
//! ```text
//! flight:   x' = v,  v' = -2 zeta v - sin x - friction + beta sin(eta t) cos x,       derivatives by t
//! contact:  x = x_r + w^2,  dt = w ds:                                               derivatives by s
//!           w' = v/2,  t' = w,
//!           v' = -w (sin x + friction - beta sin(eta t) cos x) - 2 zeta w v - (gamma + mu v) w^4
//! products: (a b)_n = sum_k a_k b_(n-k);   u = sin x, c = cos x:  n u_n = sum_k k x_k c_(n-k)
//!           y = 1 + k^2 v^2, p = atan(k v):  n p_n y_0 = k n v_n - sum_(0<j<n) j p_j y_(n-j)
//! ```
//!
//! In time the contact force (x - x_r)^(3/2) is not analytic at the touch; in s it is a polynomial in w, and touch and
//! release are simple zeros of w, however slow the touch. (The recurrences: A. Jorba and M. Zou, *Experimental Math.*
//! 14 (2005) 99; the change of variable is that of Levi-Civita and Sundman for collisions.) A left barrier is a right
//! one seen in a mirror: x, v, beta and the direction of friction change sign.
//!
//! Times are counted in a unit of choice, so that no coefficient over- or underflows. `L` motions go through the same
//! operations side by side; each gets bit for bit what it would get alone.

use super::{Equation, Loaded};
use crate::impact::model::STEEPNESS;
use crate::impact::polynomial::lanes::{values, variations};

/// Highest order of a series.
pub(super) const HIGHEST_ORDER: usize = 30;

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
    pub(super) sine: [f64; L],
    pub(super) cosine: [f64; L],
    /// sin and cos of eta t.
    pub(super) drive: [[f64; L]; 2],
    /// The unit of t, or of s.
    pub(super) unit: [f64; L],
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
            sine: zero,
            cosine: zero,
            drive: [zero; 2],
            unit: zero,
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
    /// Time since the start of the step, in contact.
    pub(super) time: Series<L>,
    sine: Series<L>,
    cosine: Series<L>,
    drive: [Series<L>; 2],
    square: Series<L>,
    angle: Series<L>,
    rate: Series<L>,
    depth: Series<L>,
    fourth: Series<L>,
    slow: Series<L>,
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
            square: zero,
            angle: zero,
            rate: zero,
            depth: zero,
            fourth: zero,
            slow: zero,
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
}

/// Those of one motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct End {
    pub(super) place: f64,
    pub(super) velocity: f64,
    /// In contact: the time that the step takes.
    pub(super) time: f64,
    /// A bound on the change of the velocity within the step.
    pub(super) variation: f64,
}

impl<const L: usize> Ends<L> {
    pub(super) fn lane(&self, lane: usize) -> End {
        End {
            place: self.place[lane],
            velocity: self.velocity[lane],
            time: self.time[lane],
            variation: self.variation[lane],
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

    /// The values of the series where the steps end.
    #[inline(always)]
    pub(super) fn ends(&self, lengths: &[f64; L], order: usize, equation: Equation) -> Ends<L> {
        let order = order.min(HIGHEST_ORDER);
        Ends {
            place: values(&self.place[..=order], lengths),
            velocity: values(&self.velocity[..=order], lengths),
            time: match equation {
                Equation::Flight => [0.0; L],
                Equation::Contact => values(&self.time[..=order], lengths),
            },
            variation: variations(&self.velocity[..=order], lengths),
        }
    }
}

/// (a b)_n. Two sums, of even and of odd k: half the waiting of one on the other.
#[inline(always)]
fn product<const L: usize>(a: &Series<L>, b: &Series<L>, n: usize) -> [f64; L] {
    let (mut even, mut odd) = ([0.0; L], [0.0; L]);
    let (a, middle) = a[..=n].as_chunks::<2>();
    let (first, b) = b[..=n].as_rchunks::<2>();
    for (a, b) in a.iter().zip(b.iter().rev()) {
        for lane in 0..L {
            even[lane] += a[0][lane] * b[1][lane];
            odd[lane] += a[1][lane] * b[0][lane];
        }
    }
    for (a, b) in middle.iter().zip(first) {
        for lane in 0..L {
            even[lane] += a[lane] * b[lane];
        }
    }
    for lane in 0..L {
        even[lane] += odd[lane];
    }
    even
}

/// (a b)_n and (a c)_n, with every a_k read once.
#[inline(always)]
fn products<const L: usize>(a: &Series<L>, [b, c]: [&Series<L>; 2], n: usize) -> [[f64; L]; 2] {
    let zero = [0.0; L];
    let (mut b_even, mut b_odd, mut c_even, mut c_odd) = (zero, zero, zero, zero);
    let (a, last) = a[..=n].as_chunks::<2>();
    let ((b_first, b), (c_first, c)) = (b[..=n].as_rchunks::<2>(), c[..=n].as_rchunks::<2>());
    for (a, (b, c)) in a.iter().zip(b.iter().zip(c).rev()) {
        for lane in 0..L {
            b_even[lane] += a[0][lane] * b[1][lane];
            b_odd[lane] += a[1][lane] * b[0][lane];
            c_even[lane] += a[0][lane] * c[1][lane];
            c_odd[lane] += a[1][lane] * c[0][lane];
        }
    }
    for (a, (b, c)) in last.iter().zip(b_first.iter().zip(c_first)) {
        for lane in 0..L {
            b_even[lane] += a[lane] * b[lane];
            c_even[lane] += a[lane] * c[lane];
        }
    }
    for lane in 0..L {
        b_even[lane] += b_odd[lane];
        c_even[lane] += c_odd[lane];
    }
    [b_even, c_even]
}

/// (a a)_n.
#[inline(always)]
fn square<const L: usize>(a: &Series<L>, n: usize) -> [f64; L] {
    let mut sum = [0.0; L];
    let half = n.div_ceil(2);
    let a = &a[..=n];
    for (low, high) in a[..half].iter().zip(a.iter().rev()) {
        for lane in 0..L {
            sum[lane] += low[lane] * high[lane];
        }
    }
    let middle = if n.is_multiple_of(2) { a[half] } else { [0.0; L] };
    for lane in 0..L {
        sum[lane] = 2.0 * sum[lane] + middle[lane] * middle[lane];
    }
    sum
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

/// The next coefficients of sine and cosine of an angle with this rate: n s_n = unit (rate c)_(n-1).
#[inline(always)]
fn sine_and_cosine<const L: usize>(
    sine: &mut Series<L>,
    cosine: &mut Series<L>,
    rate: &Series<L>,
    factor: &[f64; L],
    n: usize,
) {
    let [up, down] = products(rate, [cosine, sine], n - 1);
    for lane in 0..L {
        sine[n][lane] = factor[lane] * INVERSE[n] * up[lane];
        cosine[n][lane] = -factor[lane] * INVERSE[n] * down[lane];
    }
}

/// The next coefficient of atan(k v).
#[inline(always)]
fn arctangent<const L: usize>(angle: &mut Series<L>, squares: &mut Series<L>, velocity: &Series<L>, n: usize) {
    let steepness_squared = STEEPNESS * STEEPNESS;
    let squared = square(velocity, n);
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
    for n in 0..order {
        if n > 0 {
            sine_and_cosine(&mut series.sine, &mut series.cosine, &series.velocity, &inputs.unit, n);
        }
        let mut force: [f64; L] = each(|lane| -inputs.viscous[lane] * series.velocity[n][lane] - series.sine[n][lane]);
        if n == 0 {
            force = each(|lane| force[lane] - inputs.dry[lane]);
        }
        if terms.arctangent {
            arctangent(&mut series.angle, &mut series.square, &series.velocity, n);
            force = each(|lane| force[lane] - inputs.arctangent[lane] * series.angle[n][lane]);
        }
        if terms.excited {
            if n > 0 {
                // sin(eta t) and cos(eta t), each the derivative of the other.
                let [sine, cosine] = [series.drive[0][n - 1], series.drive[1][n - 1]];
                let factor: [f64; L] = each(|lane| inputs.unit[lane] * inputs.eta[lane] * INVERSE[n]);
                series.drive[0][n] = each(|lane| factor[lane] * cosine[lane]);
                series.drive[1][n] = each(|lane| -factor[lane] * sine[lane]);
            }
            let push = product(&series.drive[0], &series.cosine, n);
            force = each(|lane| force[lane] + inputs.beta[lane] * push[lane]);
        }
        let factor: [f64; L] = each(|lane| inputs.unit[lane] * INVERSE[n + 1]);
        series.place[n + 1] = each(|lane| factor[lane] * series.velocity[n][lane]);
        series.velocity[n + 1] = each(|lane| factor[lane] * force[lane]);
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
    for n in 0..order {
        if n > 0 {
            let rate = series.rate[n - 1];
            series.depth[n] = each(|lane| inputs.unit[lane] * INVERSE[n] * rate[lane]);
            sine_and_cosine(&mut series.sine, &mut series.cosine, &series.rate, &inputs.unit, n);
        }
        series.fourth[n] = square(&series.depth, n);
        let mut slow = series.sine[n];
        if n == 0 {
            slow = each(|lane| slow[lane] + inputs.dry[lane]);
        }
        if terms.arctangent {
            arctangent(&mut series.angle, &mut series.square, &series.velocity, n);
            slow = each(|lane| slow[lane] + inputs.arctangent[lane] * series.angle[n][lane]);
        }
        if terms.excited {
            if n > 0 {
                let factor = each(|lane| inputs.unit[lane] * inputs.eta[lane]);
                let [sine, cosine] = &mut series.drive;
                sine_and_cosine(sine, cosine, &series.place, &factor, n);
            }
            let push = product(&series.drive[0], &series.cosine, n);
            slow = each(|lane| slow[lane] - inputs.beta[lane] * push[lane]);
        }
        series.slow[n] = slow;
        // dx/ds = w v, and the depth w^2 has the same derivative.
        let [rate, carried] = products(&series.place, [&series.velocity, &series.slow], n);
        series.rate[n] = rate;
        let mut force: [f64; L] = each(|lane| {
            -carried[lane] - inputs.viscous[lane] * series.rate[n][lane] - inputs.gamma[lane] * series.fourth[n][lane]
        });
        if terms.damped_contact {
            let damped = product(&series.velocity, &series.fourth, n);
            force = each(|lane| force[lane] - inputs.mu[lane] * damped[lane]);
        }
        let factor: [f64; L] = each(|lane| inputs.unit[lane] * INVERSE[n + 1]);
        series.time[n + 1] = each(|lane| factor[lane] * series.place[n][lane]);
        series.place[n + 1] = each(|lane| 0.5 * factor[lane] * series.velocity[n][lane]);
        series.velocity[n + 1] = each(|lane| factor[lane] * force[lane]);
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
    fn by_expressions(states: &[(&str, f64)], rates: &[&str], inputs: &Inputs<1>) -> Vec<Vec<f64>> {
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
                &[("w", 0.3), ("v", 0.02), ("t", 0.7)],
                &[
                    "v/2",
                    "-w*(sin(x_r + w^2) + dry + arctangent*atan(k*v) - beta*sin(eta*t)*cos(x_r + w^2)) - viscous*w*v \
                     - (gamma + mu*v)*w^4",
                    "w",
                ],
                &now,
            );
            assert_same(&series.place, &other[0], "w");
            assert_same(&series.velocity, &other[1], "v in contact");
            assert_same(&series.time, &[&[0.0], &other[2][1..]].concat(), "t");
            let x = 0.4 + 0.3 * 0.3;
            now.place = [x];
            flight(&now, ORDER, terms, &mut series);
            let other = by_expressions(
                &[("x", x), ("v", 0.02), ("t", 0.7)],
                &[
                    "v",
                    "-viscous*v - sin(x) - dry - arctangent*atan(k*v) + beta*sin(eta*t)*cos(x)",
                    "1",
                ],
                &now,
            );
            assert_same(&series.place, &other[0], "x");
            assert_same(&series.velocity, &other[1], "v in flight");
        }
    }
}

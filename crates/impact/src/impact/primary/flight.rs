//! A flight in closed form: both modes, and their answer to the forces of third order.
//!
//! ```text
//! x'' + y'' + 2 zeta x' + x = -alpha d + N_x             N_x = (x - sin x) + (1 - cos x) y''
//! x'' + (R + 1) y'' + delta y' + kappa y = f sin(eta t) + N_y,     N_y = (x - sin x)''
//! x - sin x = (a + b u) x,   1 - cos x = c + d u,   u = x^2       for u in the range of the piece
//! z = sum of C_k exp(lambda_k t)           lambda_k: both modes, 0 for dry friction in direction d, +-i eta for the force
//! q_j' = s_j q_j + phi_j N/m_j,            N = sum of N_k exp(Lambda_k t) along the motion without N
//! q_j = exp(s_j t) (b_j + w_j t + ...) + sum of n_jk exp(Lambda_k t)/(Lambda_k - s_j)
//! ```
//!
//! Lambda_k are the sums of three of lambda_k, and lambda_k themselves. Where one of them is s_j itself
//! the answer grows as t, and is w_j: so the frequency falls with the amplitude, as 1 - A^2/16 for the
//! pendulum alone. The terms of higher order of sine and cosine are economised by Chebyshev's
//! polynomials over the angles that the motion without N takes in the piece: of x^5/120 a sixteenth of
//! its largest value is left where the piece begins or ends at x = 0, less where it does not. What is
//! left out else is the answer to the change of N by the answer to N, of fifth order in x and of fourth
//! in t: a flight is divided into pieces of a third of the faster swing or less, each of which begins
//! with the state that the last one left.
//!
//! The first event is found by steps that no event can be within: with a distance d that closes
//! with speed w, and |d''| <= B, it is not before 2 d/(w + sqrt(w^2 + 2 B d)). Near an event that is
//! Newton's step.

use nalgebra::Complex;

use super::modes::DampedModes;
use super::path::PrimaryState;
use crate::impact::model::Side;

/// Places of the exponents: mode, its conjugate, the other, its conjugate, 0, i eta, -i eta.
const EXPONENTS: usize = 7;

/// The place of the conjugate of an exponent.
const CONJUGATE: [usize; EXPONENTS] = [1, 0, 3, 2, CONSTANT, 6, 5];

const CONSTANT: usize = 4;
const FORCE: usize = 5;

const ZERO: Complex<f64> = Complex::new(0.0, 0.0);

/// The difference of two exponents below which their answer counts as growing with t.
const RESONANT: f64 = 1e-4;

/// A term of z: the real part of a coefficient times the product of three exponentials.
#[derive(Clone, Copy, Debug)]
struct Wave {
    factors: [u8; 3],
    /// Coefficients of x, x', x''.
    x: [Complex<f64>; 3],
    /// Coefficients of y, y'.
    y: [Complex<f64>; 2],
    exponent: Complex<f64>,
}

impl Wave {
    fn new(factors: [usize; 3], exponent: Complex<f64>, [x, y]: [Complex<f64>; 2]) -> Self {
        let rate = x * exponent;
        let second = rate * exponent;
        Self {
            factors: factors.map(|factor| factor as u8),
            x: [x, rate, second],
            y: [y, y * exponent],
            exponent,
        }
    }
}

/// A mode in a flight: 2 Re(phi exp(s t) (b + w t + v t^2)).
#[derive(Clone, Copy, Debug, Default)]
struct FlightMode {
    exponent: Complex<f64>,
    shape: [Complex<f64>; 2],
    /// b, w, v.
    polynomial: [Complex<f64>; 3],
}

/// The state in which a piece of a flight begins, and all else that it depends on.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlightStart {
    pub modes: DampedModes,
    pub forces: FlightForces,
    /// The time.
    pub begin: f64,
    pub state: PrimaryState,
    /// An angle beyond which the flight does not go.
    pub farthest: f64,
    /// The longest piece of small angles.
    pub longest: f64,
}

/// A piece of a flight; times count from its beginning.
#[derive(Clone, Debug, Default)]
pub(super) struct ClosedFlight {
    modes: [FlightMode; 2],
    /// eta.
    frequency: f64,
    /// The length of the piece for which sine and cosine are economised.
    time: f64,
    waves: Vec<Wave>,
}

/// Both bodies at a time, with the angular acceleration.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlightPoint {
    pub state: PrimaryState,
    pub acceleration: f64,
}

/// The end of a piece of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FlightEnd {
    /// The time that was allowed.
    Reached,
    /// A touch of this barrier.
    Touch(Side),
    /// Rest of the pendulum.
    Rest,
}

/// The constant and the harmonic forces of a flight.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlightForces {
    /// -alpha d, on the pendulum.
    pub friction: f64,
    /// f and eta, on the main mass.
    pub force: f64,
    pub frequency: f64,
}

/// The polynomials in place of x - sin x and 1 - cos x for angles up to X.
#[derive(Clone, Copy)]
struct Economised {
    /// x - sin x = linear x + cubic x^3.
    linear: f64,
    cubic: f64,
    /// 1 - cos x = constant + quadratic x^2.
    constant: f64,
    quadratic: f64,
}

impl Economised {
    /// The polynomials for squares of angles in this range.
    fn new([least, most]: [f64; 2]) -> Self {
        let (middle, half) = (0.5 * (least + most), 0.5 * (most - least));
        let [linear, cubic] = economised_line(&SINE, middle, half);
        let [constant, quadratic] = economised_line(&COSINE, middle, half);
        Self { linear, cubic, constant, quadratic }
    }
}

/// The line c + d u in place of a polynomial in u on [middle - half, middle + half]: its Taylor
/// polynomial about the middle, of whose second and third powers Chebyshev's leave h^2/2 and 3 h^2
/// u/4.
fn economised_line(polynomial: &[f64], middle: f64, half: f64) -> [f64; 2] {
    let mut taylor = [0.0; 4];
    for coefficient in polynomial.iter().rev() {
        for order in (1..taylor.len()).rev() {
            taylor[order] = taylor[order] * middle + taylor[order - 1];
        }
        taylor[0] = taylor[0] * middle + coefficient;
    }
    let [value, slope, bend, twist] = taylor;
    let slope = slope + 0.75 * twist * half * half;
    [value + 0.5 * bend * half * half - slope * middle, slope]
}

/// 1 - sin x/x and 1 - cos x by the powers of x^2.
const SINE: [f64; 7] = [
    0.0,
    1.0 / 6.0,
    -1.0 / 120.0,
    1.0 / 5_040.0,
    -1.0 / 362_880.0,
    1.0 / 39_916_800.0,
    -1.0 / 6_227_020_800.0,
];
const COSINE: [f64; 7] =
    [0.0, 0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40_320.0, 1.0 / 3_628_800.0, -1.0 / 479_001_600.0];

/// The force that a force N becomes with the force of the accelerations that it gives at once: with the
/// matrix M of the masses at x = 0 and C = 1 - cos x in the middle of the piece,
///
/// ```text
/// N' = N + C S M^-1 N',    S M^-1 = ((-1, 1), (R + 1, -1))/R
/// ```
struct Reaction {
    own: f64,
    /// Of the force on y for x, and of that on x for y.
    other: [f64; 2],
}

impl Reaction {
    fn new(middle: f64, whole: f64) -> Self {
        let share = middle / (whole - 1.0);
        let sum = 1.0 + share;
        let determinant = sum * sum - share * share * whole;
        Self {
            own: sum / determinant,
            other: [share, share * whole].map(|other| other / determinant),
        }
    }

    fn force(&self, [x, y]: [Complex<f64>; 2]) -> [Complex<f64>; 2] {
        [x * self.own + y * self.other[0], y * self.own + x * self.other[1]]
    }
}

/// The terms of the motion without N: exponents, coefficients of x and of y''.
struct TrialMotion {
    economised: Economised,
    reaction: Reaction,
    exponents: [Complex<f64>; EXPONENTS],
    x: [Complex<f64>; EXPONENTS],
    accelerations: [Complex<f64>; EXPONENTS],
}

impl TrialMotion {
    /// The third-order force on x and on y of three exponents, in each order in which they multiply.
    fn cubic(&self, [a, b, c]: [usize; 3], orders: f64) -> [Complex<f64>; 2] {
        let Self { exponents, x, accelerations, economised, .. } = self;
        let pair = x[b] * x[c];
        let cube = x[a] * pair;
        let mixed =
            accelerations[a] * pair + x[a] * (accelerations[b] * x[c] + accelerations[c] * x[b]);
        let sum = exponents[a] + exponents[b] + exponents[c];
        let cube = cube * (orders * economised.cubic);
        // Each of the three is y'' in a third of the orders.
        let mixed = mixed * (orders / 3.0 * economised.quadratic);
        self.reaction.force([mixed + cube, sum * sum * cube])
    }

    /// The range of x^2 from the beginning to this time, as far as a few looks tell, for these
    /// places of exponents and angles no greater than `farthest`.
    fn squares(&self, present: &[usize], time: f64, farthest: f64) -> [f64; 2] {
        // Those of conjugates are conjugates, to the last bit.
        let mut steps = [ZERO; EXPONENTS];
        for place in 0..EXPONENTS {
            let mirrored = CONJUGATE[place];
            steps[place] = match mirrored < place {
                true => steps[mirrored].conj(),
                false => (self.exponents[place] * (time / f64::from(LOOKS))).exp(),
            };
        }
        let mut waves = self.x;
        let mut range = [f64::INFINITY, 0.0_f64];
        let mut before = 0.0;
        for look in 0..=LOOKS {
            let x: f64 = present.iter().map(|place| waves[*place].re).sum();
            let square = x * x;
            let least = if look > 0 && before * x < 0.0 { 0.0 } else { square };
            range = [range[0].min(least), range[1].max(square)];
            before = x;
            for (wave, step) in waves.iter_mut().zip(steps) {
                *wave *= step;
            }
        }
        range.map(|square| square.min(farthest * farthest))
    }

    /// The force on x and on y of one exponent.
    fn linear(&self, a: usize) -> [Complex<f64>; 2] {
        let Self { exponents, x, accelerations, economised, .. } = self;
        let own = x[a] * economised.linear;
        let force =
            [own + accelerations[a] * economised.constant, exponents[a] * exponents[a] * own];
        self.reaction.force(force)
    }
}

impl ClosedFlight {
    /// The flight from this start; `None` where the angle is too wide, or a number overflows.
    pub(super) fn new(start: &FlightStart) -> Option<Self> {
        let mut flight = Self::default();
        flight.begin(start).then_some(flight)
    }

    /// Becomes the flight from this start; returns whether there is one.
    pub(super) fn begin(&mut self, start: &FlightStart) -> bool {
        let FlightStart { ref modes, forces, begin, state, farthest, longest } = *start;
        let mut trial = TrialMotion {
            economised: Economised::new([0.0; 2]),
            reaction: Reaction::new(0.0, modes.whole),
            exponents: [ZERO; EXPONENTS],
            x: [ZERO; EXPONENTS],
            accelerations: [ZERO; EXPONENTS],
        };
        let mut present = [0, 1, 2, 3, 0, 0, 0];
        let mut count = 4;
        let (mut z, mut rate) = ([state.x, state.y], [state.velocity, state.speed]);
        let waves = &mut self.waves;
        waves.clear();
        let one = Complex::new(1.0, 0.0);
        if forces.friction != 0.0 {
            trial.x[CONSTANT] = one * forces.friction;
            waves.push(Wave::new([CONSTANT; 3], ZERO, [trial.x[CONSTANT], ZERO]));
            z[0] -= forces.friction;
            present[count] = CONSTANT;
            count += 1;
        }
        if forces.force != 0.0 && forces.frequency != 0.0 {
            let exponent = Complex::new(0.0, forces.frequency);
            let half = Complex::new(0.0, -0.5 * forces.force) * (exponent * begin).exp();
            let answer = modes.response(exponent, [ZERO, half]);
            for (place, sign) in [(FORCE, 1.0), (CONJUGATE[FORCE], -1.0)] {
                let turned = |value: Complex<f64>| Complex::new(value.re, sign * value.im);
                trial.exponents[place] = exponent * sign;
                let [x, y] = answer.map(turned);
                trial.x[place] = x;
                trial.accelerations[place] = exponent * exponent * y;
                present[count] = place;
                count += 1;
            }
            waves.push(Wave::new(
                [FORCE, CONSTANT, CONSTANT],
                exponent,
                answer.map(|own| own * 2.0),
            ));
            for index in 0..2 {
                z[index] -= 2.0 * answer[index].re;
                rate[index] -= 2.0 * (answer[index] * exponent).re;
            }
        }
        let amplitudes = modes.amplitudes(z, rate);
        let widest: f64 = amplitudes
            .iter()
            .zip(&modes.modes)
            .map(|(amplitude, mode)| 2.0 * size(*amplitude * mode.shape[0]))
            .sum::<f64>()
            + forces.friction.abs()
            + 2.0 * size(trial.x[FORCE]);
        let widest = widest.min(farthest);
        if widest > WIDEST {
            return false;
        }
        let roots = modes.modes.map(|mode| mode.root);
        for (index, (mode, amplitude)) in modes.modes.iter().zip(amplitudes).enumerate() {
            let [x, y] = mode.shape.map(|shape| shape * amplitude);
            let acceleration = mode.root * mode.root * y;
            for (place, turn) in [(2 * index, false), (2 * index + 1, true)] {
                let turned = |value: Complex<f64>| if turn { value.conj() } else { value };
                trial.exponents[place] = turned(mode.root);
                trial.x[place] = turned(x);
                trial.accelerations[place] = turned(acceleration);
            }
        }
        self.time = longest / (1.0 + widest / WIDE);
        let squares = trial.squares(&present[..count], self.time, farthest);
        trial.economised = Economised::new(squares);
        let Economised { constant, quadratic, .. } = trial.economised;
        let middle = constant + 0.5 * quadratic * (squares[0] + squares[1]);
        trial.reaction = Reaction::new(middle, modes.whole);
        let projected = |index: usize, [x, y]: [Complex<f64>; 2]| {
            let [p, q] = modes.modes[index].projection;
            p * x + q * y
        };
        let mut polynomials = amplitudes.map(|amplitude| [amplitude, ZERO, ZERO]);
        // The answer of both modes to a force N exp(Lambda t): its coefficients of x and y.
        let mut answer = |sum: Complex<f64>, force: [Complex<f64>; 2]| {
            let mut found = [ZERO; 2];
            for (index, mode) in modes.modes.iter().enumerate() {
                let strength = projected(index, force);
                let apart = sum - roots[index];
                let polynomial = &mut polynomials[index];
                if apart.norm_sqr() < RESONANT * RESONANT {
                    polynomial[1] += strength;
                    polynomial[2] += strength * apart * 0.5;
                    continue;
                }
                let part = strength * apart.conj() * (1.0 / apart.norm_sqr());
                polynomial[0] -= part;
                for (found, shape) in found.iter_mut().zip(mode.shape) {
                    *found += part * shape;
                }
            }
            found
        };
        for &place in &present[..count] {
            let mirrored = CONJUGATE[place];
            if mirrored < place {
                continue;
            }
            let (exponent, force) = (trial.exponents[place], trial.linear(place));
            let mut z = answer(exponent, force);
            if mirrored != place {
                let other = answer(exponent.conj(), force.map(|own| own.conj()));
                z = [z[0] + other[0].conj(), z[1] + other[1].conj()];
            }
            waves.push(Wave::new([place, CONSTANT, CONSTANT], exponent, z.map(|own| own * 2.0)));
        }
        for a in 0..count {
            for b in a..count {
                for c in b..count {
                    let three = [a, b, c].map(|index| present[index]);
                    let mut mirrored = three.map(|place| CONJUGATE[place]);
                    mirrored.sort_unstable();
                    if mirrored < three {
                        continue;
                    }
                    let orders = match (a == b, b == c) {
                        (true, true) => 1.0,
                        (false, false) => 6.0,
                        _ => 3.0,
                    };
                    let force = trial.cubic(three, orders);
                    let sum =
                        three.iter().map(|place| trial.exponents[*place]).sum::<Complex<f64>>();
                    let mut z = answer(sum, force);
                    if mirrored != three {
                        let other = answer(sum.conj(), force.map(|own| own.conj()));
                        z = [z[0] + other[0].conj(), z[1] + other[1].conj()];
                    }
                    waves.push(Wave::new(three, sum, z.map(|own| own * 2.0)));
                }
            }
        }
        self.modes = [0, 1].map(|index| FlightMode {
            exponent: roots[index],
            shape: modes.modes[index].shape,
            polynomial: polynomials[index],
        });
        self.frequency = forces.frequency;
        self.bound(2, 1.0).is_finite()
    }

    /// The length of the piece for which the flight is made.
    pub(super) fn time(&self) -> f64 {
        self.time
    }

    /// A bound of the derivative of x of the second or third order over this time.
    fn bound(&self, order: u8, time: f64) -> f64 {
        let is_third = order > 2;
        let waves = self.waves.iter().map(|wave| match is_third {
            true => size(wave.x[2] * wave.exponent),
            false => size(wave.x[2]),
        });
        let mut growth: f64 = 0.0;
        let modes = self.modes.iter().map(|mode| {
            let [b, w, v] = mode.polynomial.map(size);
            let root = size(mode.exponent);
            growth = growth.max(mode.exponent.re);
            // The derivatives of the polynomial and of exp(s t).
            let [zeroth, first, second] = [b + (w + v * time) * time, w + 2.0 * v * time, 2.0 * v];
            let own = match is_third {
                true => root * (root * (root * zeroth + 3.0 * first) + 3.0 * second),
                false => root * (root * zeroth + 2.0 * first) + second,
            };
            2.0 * size(mode.shape[0]) * own
        });
        let sum = waves.sum::<f64>() + modes.sum::<f64>();
        if growth > 0.0 { sum * (3.0 * growth * time).exp() } else { sum }
    }

    /// Both bodies at this time since the beginning.
    pub(super) fn point(&self, t: f64) -> FlightPoint {
        let mut exponentials = [Complex::new(1.0, 0.0); EXPONENTS];
        let (mut x, mut y) = ([0.0; 3], [0.0; 2]);
        for (index, mode) in self.modes.iter().enumerate() {
            let wave = (mode.exponent * t).exp();
            exponentials[2 * index] = wave;
            exponentials[2 * index + 1] = wave.conj();
            let [b, w, v] = mode.polynomial;
            let [value, slope, bend] = [b + (w + v * t) * t, w + v * (2.0 * t), v * 2.0];
            let s = mode.exponent;
            let rates = [value, s * value + slope, s * (s * value + slope * 2.0) + bend];
            let rates = rates.map(|rate| rate * wave * 2.0);
            for (sum, rate) in x.iter_mut().zip(rates) {
                *sum += (mode.shape[0] * rate).re;
            }
            for (sum, rate) in y.iter_mut().zip(rates) {
                *sum += (mode.shape[1] * rate).re;
            }
        }
        if self.frequency != 0.0 {
            let wave = Complex::new(0.0, self.frequency * t).exp();
            exponentials[FORCE] = wave;
            exponentials[CONJUGATE[FORCE]] = wave.conj();
        }
        for wave in &self.waves {
            let [a, b, c] = wave.factors.map(|factor| exponentials[usize::from(factor)]);
            let product = a * b * c;
            let real = |own: &Complex<f64>| own.re * product.re - own.im * product.im;
            for (sum, own) in x.iter_mut().zip(&wave.x) {
                *sum += real(own);
            }
            for (sum, own) in y.iter_mut().zip(&wave.y) {
                *sum += real(own);
            }
        }
        FlightPoint {
            state: PrimaryState { x: x[0], velocity: x[1], y: y[0], speed: y[1] },
            acceleration: x[2],
        }
    }

    /// The first event of the flight, at most this long after its beginning: a touch of one of these
    /// barriers, or the end of a slip in this direction. The motion leaves an event at which it
    /// begins.
    pub(super) fn first_event(
        &self,
        barriers: [Option<f64>; 2],
        slip: f64,
        time: f64,
    ) -> (f64, FlightEnd, FlightPoint) {
        let second = self.bound(2, time);
        let third = if slip == 0.0 { 0.0 } else { self.bound(3, time) };
        let mut t = 0.0;
        for step in 0..MOST_STEPS {
            let point = self.point(t);
            let PrimaryState { x, velocity, .. } = point.state;
            // The time that no event is within, and the event that may be next.
            let mut free = time - t;
            if free <= NEAR * time {
                return (time, FlightEnd::Reached, point);
            }
            let mut look = |distance: f64, closing: f64, bound: f64, end: FlightEnd| {
                let is_here = distance <= NEAR && closing > 0.0 && step > 0;
                let least = if distance <= NEAR { LEAST } else { 0.0 };
                free = free.min(safe_step(distance, closing, bound).max(least));
                is_here.then_some(end)
            };
            let mut here = None;
            for (place, side) in barriers.iter().zip([Side::Left, Side::Right]) {
                if let Some(place) = place {
                    let sign = side.sign();
                    let end = FlightEnd::Touch(side);
                    here = here.or(look(sign * (place - x), sign * velocity, second, end));
                }
            }
            if slip != 0.0 {
                let closing = -slip * point.acceleration;
                here = here.or(look(slip * velocity, closing, third, FlightEnd::Rest));
            }
            if let Some(end) = here {
                return (t, end, point);
            }
            t += free;
        }
        let point = self.point(t);
        (t, FlightEnd::Reached, point)
    }
}

/// The absolute value, without the care for overflow of `norm`.
fn size(value: Complex<f64>) -> f64 {
    value.norm_sqr().sqrt()
}

/// A time within which a distance that closes with this speed, and whose second derivative is
/// bounded, is not zero.
pub(super) fn safe_step(distance: f64, closing: f64, bound: f64) -> f64 {
    let distance = distance.max(0.0);
    let root = (closing * closing + 2.0 * bound * distance).sqrt();
    match closing > 0.0 {
        true => 2.0 * distance / (closing + root),
        false => (root - closing) / bound,
    }
}

/// The widest swing, rad, of a flight in closed form.
const WIDEST: f64 = 1.6;

/// The angle, rad, at which a piece is half as long as one of small angles: the wider the swing, the
/// larger the terms that are left out.
const WIDE: f64 = 0.2;

/// Looks at the angles of a piece, in equal steps.
const LOOKS: u32 = 4;

/// The distance, in rad or in rad omega, that counts as none.
const NEAR: f64 = 1e-13;

/// The time for which a flight that begins at an event has left it.
const LEAST: f64 = 1e-4;

/// Largest number of steps towards an event; a piece of a flight that needs more is divided.
const MOST_STEPS: usize = 300;

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix4, Vector4};

    use super::*;
    use crate::impact::Model;
    use crate::impact::primary::{Primary, PrimaryCase, PrimarySettings, simulate_primary};

    fn case(mass: f64, ratio: f64, zeta: f64, start: [f64; 4]) -> PrimaryCase {
        let stiffness = ratio * mass;
        let damping = 0.06 * stiffness.sqrt();
        let primary = Primary { mass, stiffness, damping, force: 0.0, frequency: 0.0 };
        let model = Model { zeta, left: None, right: None, ..Model::default() };
        PrimaryCase { primary, model, start }
    }

    fn flight(case: &PrimaryCase, friction: f64) -> ClosedFlight {
        let [x, velocity, y, speed] = case.start;
        let Primary { force, frequency, .. } = case.primary;
        let start = FlightStart {
            modes: DampedModes::new(case).expect("two modes"),
            forces: FlightForces { friction, force, frequency },
            begin: 0.0,
            state: PrimaryState { x, velocity, y, speed },
            farthest: f64::INFINITY,
            longest: 2.0,
        };
        ClosedFlight::new(&start).expect("a flight")
    }

    const CASES: [(f64, f64); 6] =
        [(5.0, 0.6), (20.0, 1.0), (20.0, 2.5), (50.0, 2.5), (100.0, 6.0), (100.0, 1.0)];

    /// The matrix exponential of the equations of first order, for angles whose cube is nothing.
    #[test]
    fn a_small_flight_is_the_matrix_exponential() {
        for (mass, ratio) in CASES {
            let small = case(mass, ratio, 0.03, [2e-6, -1e-6, 1e-6, 3e-6]);
            let Primary { stiffness, damping, .. } = small.primary;
            let friction = 5e-7;
            let (m, r) = (mass + 1.0, mass);
            #[rustfmt::skip]
            let rates = Matrix4::new(
                0.0, 0.0, 1.0, 0.0,
                0.0, 0.0, 0.0, 1.0,
                -m / r, stiffness / r, -0.06 * m / r, damping / r,
                1.0 / r, -stiffness / r, 0.06 / r, -damping / r,
            );
            let [x, velocity, y, speed] = small.start;
            let flight = flight(&small, friction);
            for t in [0.0, 0.3, 1.0, 2.0, 7.0] {
                // A constant torque moves the place of rest.
                let start = Vector4::new(x - friction, y, velocity, speed);
                let truth = (rates * t).exp() * start + Vector4::new(friction, 0.0, 0.0, 0.0);
                let PrimaryState { x, velocity, y, speed } = flight.point(t).state;
                let found = Vector4::new(x, y, velocity, speed);
                assert!((found - truth).amax() < 1e-15, "{mass} {ratio} {t}: {found} {truth}");
            }
        }
    }

    /// The terms that are left out are of fifth order in the angle: a third of the size has 3^5 less of
    /// them.
    #[test]
    fn the_error_of_a_flight_is_of_fifth_order() {
        let settings = PrimarySettings { duration: 1.0, ..PrimarySettings::default() };
        for (mass, ratio) in CASES {
            let error = |size: f64| {
                let mut own = case(mass, ratio, 0.02, [size, -0.5 * size, 0.1 * size, 0.2 * size]);
                own.primary.force = 0.02 * mass * size;
                own.primary.frequency = 1.9;
                let truth = simulate_primary(own, &settings).expect("a motion");
                let truth = truth.state_at(1.0).expect("a state");
                let state = flight(&own, 0.0).point(1.0).state;
                (state.x - truth.x).hypot(state.velocity - truth.velocity)
            };
            let [large, small] = [0.15, 0.05].map(error);
            assert!(large < 5e-3, "{mass} {ratio}: {large}");
            assert!(small < large / 150.0, "{mass} {ratio}: {large} {small}");
        }
    }

    /// Velocity and acceleration are the derivatives of the angle, and the speed that of y.
    #[test]
    fn the_rates_are_derivatives() {
        let wide = case(20.0, 2.5, 0.02, [0.6, 0.4, 0.1, -0.1]);
        let flight = flight(&wide, -0.05);
        for t in [0.1, 0.7, 1.4] {
            let step = 1e-5;
            let [before, here, after] = [t - step, t, t + step].map(|t| flight.point(t));
            let slope = |one: f64, other: f64| (other - one) / (2.0 * step);
            let (state, one, other) = (here.state, before.state, after.state);
            assert!((slope(one.x, other.x) - state.velocity).abs() < 1e-9);
            assert!((slope(one.y, other.y) - state.speed).abs() < 1e-9);
            assert!((slope(one.velocity, other.velocity) - here.acceleration).abs() < 1e-9);
        }
    }

    /// No touch before the one found, by a thousand looks, for barriers that are nearly grazed.
    #[test]
    fn the_first_event_is_the_first() {
        let mut touches = 0;
        for index in 0..60 {
            let turn = f64::from(index);
            let own = case(20.0, 2.5, 0.02, [0.1 * turn.sin(), 0.4 * (2.0 * turn).cos(), 0.2, 0.1]);
            let flight = flight(&own, 0.0);
            let time = 6.0;
            let looks: Vec<f64> = (0..=20_000)
                .map(|look| flight.point(time * f64::from(look) / 2e4).state.x)
                .collect();
            let highest = looks.iter().take(5000).copied().fold(0.0, f64::max);
            // A hair below and above the first crest.
            for place in [highest - 1e-7, highest + 1e-7, 0.9 * highest] {
                let barriers = [Some(-0.9 * highest - 0.2), Some(place)];
                if own.start[0] >= place {
                    continue;
                }
                let (t, end, point) = flight.first_event(barriers, 0.0, time);
                let first =
                    looks.iter().position(|x| *x > place || *x < barriers[0].unwrap_or(0.0));
                match (end, first) {
                    (FlightEnd::Reached, None) => assert_eq!(t, time),
                    (FlightEnd::Touch(side), Some(look)) => {
                        touches += 1;
                        let latest = time * look as f64 / 2e4;
                        assert!(t <= latest + 1e-9 && t > latest - 0.01, "{index}: {t} {latest}");
                        let place = barriers[usize::from(side == Side::Right)].expect("a barrier");
                        assert!((point.state.x - place).abs() < 1e-12, "{index}");
                    }
                    // A crest between two looks is higher than both.
                    (FlightEnd::Touch(_), None) => {
                        assert!((point.state.x - place).abs() < 1e-12 && place > highest - 1e-6)
                    }
                    (found, wanted) => panic!("{index} {place}: {found:?} {wanted:?}"),
                }
            }
        }
        assert!(touches > 60, "{touches}");
    }
}

//! Motions of a linear oscillator over a time that is known up to a radius, enclosed.
//!
//! ```text
//! r'' + c r' + k r = 1,  r(0) = r'(0) = 0           the motion from rest under a unit force
//! Phi = ((1 - k r, S), (-k S, 1 - k r - c S)),  S = r'
//! Phi(2 t) = Phi(t)^2,   r(2 t) = Phi(t) r(t) + r(t)
//! ```
//!
//! One Taylor series serves underdamped, overdamped and critically damped motions and those without
//! stiffness, and with `c = 0`, `k = 1` sine and cosine. In: the coefficients and a time as balls.
//! Out: the fundamental matrix and the motion from rest. It costs some two hundred products.
//!
//! The time is halved until `|c| h <= 1/2` and `|k| h^2 <= 1/4`. Then the Taylor terms of S are at
//! most `h/j!`: by induction, since `1/2 + 1/4 <= 1`, and what is left of S from the term N on is at
//! most `2 h/N!`, of r at most h times that. A time with a large radius is the sum of its middle and of
//! the rest, over which the motion is small.

use crate::certificate::fourier_series::WORKING;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;

/// The number of terms of the Taylor series: `60!` exceeds `2^272`.
const TERMS: u32 = 60;

/// The largest number of halvings of a time.
const MOST_HALVINGS: u32 = 40;

/// Position and velocity, or their derivatives.
pub(super) type State = [Ball; 2];

/// A linear oscillator `x'' + c x' + k x = p` without a drive.
#[derive(Clone, Debug)]
pub(super) struct LinearFlow {
    /// c.
    pub(super) damping: Ball,
    /// k.
    pub(super) stiffness: Ball,
}

/// The motion of a [`LinearFlow`] over a time.
#[derive(Clone, Debug)]
pub(super) struct Propagator {
    /// The fundamental matrix, by rows.
    pub(super) matrix: [State; 2],
    /// Position and velocity from rest under a unit force.
    pub(super) from_rest: State,
}

pub(super) fn product(left: &Ball, right: &Ball) -> Ball {
    WORKING.product(left, right)
}

pub(super) fn sum(left: &Ball, right: &Ball) -> Ball {
    WORKING.sum(left, right)
}

pub(super) fn difference(left: &Ball, right: &Ball) -> Ball {
    WORKING.difference(left, right)
}

pub(super) fn negative(ball: &Ball) -> Ball {
    WORKING.scaled(ball, -1)
}

/// The sum of two states.
pub(super) fn state_sum(left: &State, right: &State) -> State {
    [0, 1].map(|row| sum(&left[row], &right[row]))
}

/// The difference of two states.
pub(super) fn state_difference(left: &State, right: &State) -> State {
    [0, 1].map(|row| difference(&left[row], &right[row]))
}

/// The product of a matrix and a state.
pub(super) fn image(matrix: &[State; 2], state: &State) -> State {
    [0, 1].map(|row| {
        let [left, right] = &matrix[row];
        sum(&product(left, &state[0]), &product(right, &state[1]))
    })
}

/// The product of two matrices.
pub(super) fn matrix_product(left: &[State; 2], right: &[State; 2]) -> [State; 2] {
    let column = |column: usize| image(left, &[0, 1].map(|row| right[row][column].clone()));
    let [first, second] = [column(0), column(1)];
    [0, 1].map(|row| [first[row].clone(), second[row].clone()])
}

impl LinearFlow {
    /// The flow whose fundamental matrix is `((cos, sin), (-sin, cos))`.
    pub(super) fn rotation() -> Self {
        Self { damping: Ball::zero(), stiffness: WORKING.integer(1) }
    }

    /// The motion over every time in a ball; `None` where the coefficients are too large.
    pub(super) fn over(&self, time: &Ball) -> Option<Propagator> {
        let middle = Ball { radius: Bound::ZERO, ..time.clone() };
        let at_middle = self.over_short(&middle)?;
        if time.radius == Bound::ZERO {
            return Some(at_middle);
        }
        let rest = self.over_short(&Ball { radius: time.radius, ..Ball::zero() })?;
        Some(rest.after(&at_middle))
    }

    /// The same, with wider results for a time with a radius.
    fn over_short(&self, time: &Ball) -> Option<Propagator> {
        let [damping, stiffness, length] =
            [&self.damping, &self.stiffness, time].map(|ball| WORKING.magnitude(ball).value());
        let is_small = |halvings: &u32| {
            let step = length * 0.5_f64.powi(*halvings as i32);
            // Rounded comparisons: both limits have a margin far above the rounding.
            damping * step < 0.499 && stiffness * step * step < 0.249
        };
        let halvings = (0..=MOST_HALVINGS).find(is_small)?;
        let step = (0..halvings).fold(time.clone(), |step, _| WORKING.divided(&step, 2));
        let mut propagator = self.series(&step);
        for _ in 0..halvings {
            propagator = propagator.after(&propagator);
        }
        Some(propagator)
    }

    /// The Taylor series over a time that is short enough.
    fn series(&self, step: &Ball) -> Propagator {
        let drag = negative(&product(&self.damping, step));
        let pull = negative(&product(&product(&self.stiffness, step), step));
        let (mut before, mut term) = (Ball::zero(), step.clone());
        // `term` is that of S with the power `order` of the time.
        let (mut sine, mut displacement) = (Ball::zero(), Ball::zero());
        for order in 1..TERMS {
            sine = sum(&sine, &term);
            displacement = sum(&displacement, &WORKING.divided(&term, order + 1));
            let by_drag = WORKING.scaled(&product(&drag, &term), i64::from(order));
            let next = sum(&by_drag, &product(&pull, &before));
            before = term;
            term = WORKING.divided(&next, order * (order + 1));
        }
        let factorial = (1..=TERMS).fold(Bound::exactly(2.0), |bound, k| bound / k);
        let left_out = WORKING.magnitude(step) * factorial;
        sine.radius += left_out;
        let mut displacement = product(&displacement, step);
        displacement.radius += WORKING.magnitude(step) * left_out;
        let cosine = difference(&WORKING.integer(1), &product(&self.stiffness, &displacement));
        let matrix = [
            [cosine.clone(), sine.clone()],
            [
                negative(&product(&self.stiffness, &sine)),
                difference(&cosine, &product(&self.damping, &sine)),
            ],
        ];
        Propagator { matrix, from_rest: [displacement, sine] }
    }
}

impl Propagator {
    /// The motion that follows another one of the same flow.
    fn after(&self, first: &Self) -> Self {
        Self {
            matrix: matrix_product(&self.matrix, &first.matrix),
            from_rest: state_sum(&image(&self.matrix, &first.from_rest), &self.from_rest),
        }
    }

    /// The state at the end, from a state under a constant force.
    pub(super) fn advance(&self, state: &State, force: &Ball) -> State {
        let forced = [0, 1].map(|row| product(force, &self.from_rest[row]));
        state_sum(&image(&self.matrix, state), &forced)
    }
}

#[cfg(test)]
mod tests {
    use num_traits::Signed as _;

    use super::*;
    use crate::exact::Rational;
    use crate::exact::rational::{from_f64, to_f64};

    fn ball(above: i64, below: i64) -> Ball {
        WORKING.fraction(&Rational::new(above.into(), below.into()))
    }

    fn flow(damping: Ball, stiffness: Ball) -> LinearFlow {
        LinearFlow { damping, stiffness }
    }

    /// Whether a double is in the ball, but for its rounding.
    fn is_near(ball: &Ball, value: f64) -> bool {
        (WORKING.nearest(ball) - value).abs() <= 1e-13 * value.abs().max(1.0) + ball.radius.value()
    }

    #[test]
    fn motions_are_those_of_textbooks() {
        // Underdamped, critically damped, overdamped, without stiffness, without damping.
        let time = 7.0_f64 / 3.0;
        let (rate, decay) = (0.96_f64.sqrt(), (-0.2 * time).exp());
        let under = [decay * (rate * time).sin() / rate];
        let cases = [
            (ball(2, 5), ball(1, 1), under[0]),
            (ball(2, 1), ball(1, 1), time * (-time).exp()),
            (ball(5, 2), ball(1, 1), ((-0.5 * time).exp() - (-2.0 * time).exp()) / 1.5),
            (ball(1, 2), Ball::zero(), (1.0 - (-0.5 * time).exp()) / 0.5),
            (Ball::zero(), ball(9, 1), (3.0 * time).sin() / 3.0),
            (Ball::zero(), ball(-1, 1), time.sinh()),
            (Ball::zero(), Ball::zero(), time),
        ];
        for (damping, stiffness, sine) in cases {
            let found = flow(damping, stiffness).over(&ball(7, 3)).expect("a motion");
            assert!(is_near(&found.matrix[0][1], sine), "{sine}: {found:?}");
            assert!(found.matrix[0][1].radius.value() < 1e-58, "{found:?}");
        }
        let circle = LinearFlow::rotation().over(&ball(100, 1)).expect("a motion");
        assert!(is_near(&circle.matrix[0][0], 100.0_f64.cos()));
        assert!(is_near(&circle.from_rest[1], 100.0_f64.sin()));
        assert!(is_near(&circle.from_rest[0], 1.0 - 100.0_f64.cos()));
    }

    /// The determinant of the fundamental matrix is `exp(-c t)`, and forwards and back is rest.
    #[test]
    fn time_may_run_backwards() {
        let flow = flow(ball(1, 7), ball(5, 3));
        let [there, back] = [ball(11, 2), ball(-11, 2)].map(|time| flow.over(&time).expect("one"));
        let unit = matrix_product(&back.matrix, &there.matrix);
        for (row, own) in unit.iter().enumerate() {
            for (column, entry) in own.iter().enumerate() {
                let rest = WORKING.difference(entry, &WORKING.integer(i64::from(row == column)));
                assert!(WORKING.distance_from_zero(&rest) <= 0.0 && entry.radius.value() < 1e-55);
            }
        }
        let [[a, b], [c, d]] = &there.matrix;
        let determinant = difference(&product(a, d), &product(b, c));
        assert!(is_near(&determinant, (-11.0_f64 / 14.0).exp()));
    }

    /// A ball of times has the motions over all of them, and little more.
    #[test]
    fn a_time_with_a_radius_has_all_motions() {
        let flow = flow(ball(1, 10), ball(4, 1));
        let wide = Ball { radius: Bound::exactly(0.125), ..ball(9, 4) };
        let all = flow.over(&wide).expect("a motion");
        for time in [ball(17, 8), ball(9, 4), ball(37, 16), ball(19, 8)] {
            let one = flow.over(&time).expect("a motion");
            let pairs = all.matrix.iter().flatten().zip(one.matrix.iter().flatten());
            for (whole, part) in pairs.chain(all.from_rest.iter().zip(&one.from_rest)) {
                let apart = (WORKING.middle(whole) - WORKING.middle(part)).abs();
                let radius = from_f64(whole.radius.value()).expect("finite");
                assert!(apart <= radius, "{} {}", to_f64(&apart), whole.radius.value());
            }
        }
        assert!(all.matrix[0][1].radius.value() < 0.4);
        assert!(flow.over(&Ball { radius: Bound::UNKNOWN, ..Ball::zero() }).is_none());
    }
}

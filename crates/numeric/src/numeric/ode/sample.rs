//! The samples of a trajectory: values at a time, of first-order equations or as the displacement
//! and velocity of one coordinate.

use std::fmt::Debug;

use super::State;

/// The values of first-order equations: an array, with which a step allocates nothing, or a vector
/// where their number is known at run time only.
pub trait StateVector:
    differential_equations::traits::State<f64> + AsRef<[f64]> + AsMut<[f64]>
{
    /// The first values, so many of them; all of an array.
    #[must_use]
    fn leading(&self, count: usize) -> Self;
}

impl<const N: usize> StateVector for [f64; N] {
    fn leading(&self, _count: usize) -> Self {
        *self
    }
}

impl StateVector for Vec<f64> {
    fn leading(&self, count: usize) -> Self {
        self[..count.min(self.len())].to_vec()
    }
}

/// A point of a motion.
pub trait Sample: Clone + Debug {
    /// The dependent variables.
    type Values: StateVector;

    /// A sample from a time and the values at it.
    fn new(t: f64, values: Self::Values) -> Self;

    /// The time.
    fn time(&self) -> f64;

    /// The values at that time.
    fn values(&self) -> Self::Values;

    /// The value of this index.
    fn value(&self, index: usize) -> f64;

    /// Sets the time and the first values, so many of them, by their index.
    fn set(&mut self, t: f64, count: usize, value: impl Fn(usize) -> f64);

    /// The values at `t` within a step of the implicit method, from those at its ends, where that
    /// is better than the method's own interpolant.
    fn between(
        _from: (f64, &Self::Values),
        _to: (f64, &Self::Values),
        _t: f64,
    ) -> Option<Self::Values> {
        None
    }

    /// Whether the time and all values are finite.
    fn is_finite(&self) -> bool {
        self.time().is_finite() && self.values().as_ref().iter().all(|value| value.is_finite())
    }
}

/// A point of the motion of any first-order equations. Also the initial condition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point<Y> {
    /// Time.
    pub t: f64,
    /// The values, in the order of the equations.
    pub y: Y,
}

impl<Y: StateVector> Sample for Point<Y> {
    type Values = Y;

    fn new(t: f64, values: Y) -> Self {
        Self { t, y: values }
    }

    fn time(&self) -> f64 {
        self.t
    }

    fn values(&self) -> Y {
        self.y.clone()
    }

    fn value(&self, index: usize) -> f64 {
        self.y.as_ref()[index]
    }

    fn set(&mut self, t: f64, count: usize, value: impl Fn(usize) -> f64) {
        self.t = t;
        for (index, own) in self.y.as_mut().iter_mut().take(count).enumerate() {
            *own = value(index);
        }
    }

    fn is_finite(&self) -> bool {
        self.t.is_finite() && self.y.as_ref().iter().all(|value| value.is_finite())
    }
}

impl Sample for State {
    type Values = [f64; 2];

    fn new(t: f64, [x, v]: [f64; 2]) -> Self {
        Self { t, x, v }
    }

    fn time(&self) -> f64 {
        self.t
    }

    fn values(&self) -> [f64; 2] {
        [self.x, self.v]
    }

    fn value(&self, index: usize) -> f64 {
        if index == 0 { self.x } else { self.v }
    }

    fn set(&mut self, t: f64, count: usize, value: impl Fn(usize) -> f64) {
        let [x, v] = [0, 1].map(|index| (index < count).then(|| value(index)));
        *self = Self { t, x: x.unwrap_or(self.x), v: v.unwrap_or(self.v) };
    }

    /// The cubic Hermite interpolant of displacement and velocity at both ends of a step. It leaves
    /// out the accelerations, which in a stiff motion magnify every error of the velocity.
    fn between(
        (from, [x, v]): (f64, &[f64; 2]),
        (to, [x1, v1]): (f64, &[f64; 2]),
        t: f64,
    ) -> Option<[f64; 2]> {
        let length = to - from;
        // In units of the step.
        let (v, v1, rise) = (length * v, length * v1, x1 - x);
        let s = (t - from) / length;
        let (c2, c3) = (3.0 * rise - 2.0 * v - v1, v + v1 - 2.0 * rise);
        let position = x + s * (v + s * (c2 + s * c3));
        let velocity = (v + s * (2.0 * c2 + s * 3.0 * c3)) / length;
        (position.is_finite() && velocity.is_finite()).then_some([position, velocity])
    }
}

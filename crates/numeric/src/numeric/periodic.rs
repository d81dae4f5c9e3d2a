//! Periodic motions of a driven equation, found by Newton's method on the map of one period.
//!
//! Reference: A. H. Nayfeh, B. Balachandran, *Applied Nonlinear Dynamics*, Wiley 1995, section 5.1
//! (shooting) and 3.2 (Floquet multipliers).
//!
//! ```text
//! x'' = g(t, x, v),  g of period T in t:      M(x(0), v(0)) = (x(T), v(T)),      M(y) = y by Newton's method
//! multipliers: the eigenvalues of dM/dy;      the motion attracts where both lie inside the unit circle
//! ```
//!
//! The start is only where the search begins: the motion found is one of the equation alone, stable
//! or not. Motions that are known already are kept away from by deflation (P. E. Farrell, A.
//! Birkisson, S. W. Funke, SIAM J. Sci. Comput. 37, 2015, A2026):
//!
//! ```text
//! Newton on  eta(y) (M(y) - y),  eta = product of (1 + 1/|y - y_known|^2):  the step of Newton's method over 1 - (grad eta . step)/eta
//! ```

use std::f64::consts::TAU;

use nalgebra::{Matrix2, Vector2};

use crate::numeric::ode::{Options, State, Trajectory, integrate};

/// A periodic motion, from the start of its period.
#[derive(Clone, Debug)]
pub struct PeriodicMotion {
    path: Trajectory,
    period: f64,
    /// Real and imaginary part of the eigenvalues of the map of one period.
    pub multipliers: [(f64, f64); 2],
}

/// Why no periodic motion was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoPeriodicMotion {
    /// Newton's steps did not settle.
    #[error("no motion of period {0} was found near the one by the formula")]
    NotFound(f64),
    /// The motion could not be followed over one period.
    #[error("the motion could not be followed over one period, {0}")]
    Lost(f64),
}

impl PeriodicMotion {
    /// Its period.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Position and velocity at a time between zero and the period.
    pub fn at(&self, t: f64) -> (f64, f64) {
        self.path.at(t).unwrap_or((f64::NAN, f64::NAN))
    }

    /// Whether neighbouring motions come closer.
    pub fn attracts(&self) -> bool {
        self.multipliers.iter().all(|value| value.0.hypot(value.1) < 1.0)
    }

    /// The amplitude of a harmonic of the period, `sqrt(c^2 + s^2)` of its cosine and sine.
    pub fn harmonic(&self, number: u32) -> f64 {
        const SAMPLES: usize = 4096;
        let sample = |k: usize| {
            let part = k as f64 / SAMPLES as f64;
            let x = self.at(part * self.period).0;
            let angle = TAU * f64::from(number) * part;
            (x * angle.cos(), x * angle.sin())
        };
        let sum = (0..SAMPLES).map(sample).fold((0.0, 0.0), |sum, (c, s)| (sum.0 + c, sum.1 + s));
        2.0 * sum.0.hypot(sum.1) / SAMPLES as f64
    }
}

/// The periodic motion near a start, position and velocity at `t = 0`; `size` is about how large it
/// is.
///
/// # Errors
/// None was found near there, or the motion cannot be followed.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::periodic::periodic_motion;
///
/// // x'' + x'/5 + x = cos(2t)
/// let found = periodic_motion(&|t, x, v| (2.0 * t).cos() - x - 0.2 * v, std::f64::consts::PI, [0.0, 0.0], 1.0)?;
/// assert!((found.harmonic(1) - 1.0 / 9.16_f64.sqrt()).abs() < 1e-9 && found.attracts());
/// # Ok::<(), lindstedt::numeric::periodic::NoPeriodicMotion>(())
/// ```
pub fn periodic_motion(
    acceleration: &dyn Fn(f64, f64, f64) -> f64,
    period: f64,
    start: [f64; 2],
    size: f64,
) -> Result<PeriodicMotion, NoPeriodicMotion> {
    another_periodic_motion(acceleration, period, start, size, &[])
}

/// A periodic motion near a start that is none of those that begin at the known places.
///
/// # Errors
/// None was found near there, or the motion cannot be followed.
pub fn another_periodic_motion(
    acceleration: &dyn Fn(f64, f64, f64) -> f64,
    period: f64,
    start: [f64; 2],
    size: f64,
    known: &[[f64; 2]],
) -> Result<PeriodicMotion, NoPeriodicMotion> {
    const STEPS: usize = 30;
    const SETTLED: f64 = 1e-11;
    /// The finite differences of the map, beside the size of the motion: far above the error of
    /// integration.
    const DIFFERENCE: f64 = 1e-5;
    let rate = TAU / period;
    let scale = [size, size * rate];
    let lost = NoPeriodicMotion::Lost(period);
    let path = |place: Vector2<f64>| {
        let [x, v] = [place[0], place[1]];
        let mut options = Options::with_tolerance(1e-12);
        options.absolute_tolerance = 1e-13 * size;
        let path = integrate(acceleration, State { t: 0.0, x, v }, period, &[], &options);
        path.ok().filter(Trajectory::is_complete).ok_or(lost)
    };
    let end = |path: &Trajectory| Vector2::new(path.end().x, path.end().v);
    let slopes = |place: Vector2<f64>| -> Result<Matrix2<f64>, NoPeriodicMotion> {
        let column = |index: usize| {
            let mut step = Vector2::zeros();
            step[index] = DIFFERENCE * scale[index];
            let difference = end(&path(place + step)?) - end(&path(place - step)?);
            Ok(difference / (2.0 * step[index]))
        };
        Ok(Matrix2::from_columns(&[column(0)?, column(1)?]))
    };
    // grad eta . step over eta
    let pull = |place: Vector2<f64>, step: Vector2<f64>| -> f64 {
        let of_one = |[x, v]: &[f64; 2]| {
            let apart = Vector2::new((place[0] - x) / scale[0], (place[1] - v) / scale[1]);
            let square = apart.norm_squared();
            -2.0 * (apart[0] * step[0] / scale[0] + apart[1] * step[1] / scale[1])
                / (square * (square + 1.0))
        };
        known.iter().map(of_one).sum()
    };
    let mut place = Vector2::new(start[0], start[1]);
    for _ in 0..STEPS {
        let excess = end(&path(place)?) - place;
        let map = slopes(place)?;
        let Some(inverse) = (map - Matrix2::identity()).try_inverse() else {
            break;
        };
        let step = inverse * excess;
        let step = step / (1.0 + pull(place, step));
        // A step far beyond the size of the motion leads to another one, or nowhere.
        let length = (step[0] / scale[0]).hypot(step[1] / scale[1]);
        if !length.is_finite() {
            break;
        }
        place -= step * f64::min(1.0, 0.5 / length);
        if length < SETTLED {
            let found = slopes(place)?.complex_eigenvalues();
            return Ok(PeriodicMotion {
                path: path(place)?,
                period,
                multipliers: [(found[0].re, found[0].im), (found[1].re, found[1].im)],
            });
        }
    }
    Err(NoPeriodicMotion::NotFound(period))
}

//! Periodic orbits of first-order equations with any number of states, found by shooting: Newton's
//! method on the map of one period.
//!
//! References: A. H. Nayfeh, B. Balachandran, *Applied Nonlinear Dynamics*, Wiley 1995, section 5.1
//! (shooting) and 3.2 (Floquet multipliers); R. Seydel, *Practical Bifurcation and Stability
//! Analysis*, Springer 2010, chapter 7 (the phase condition).
//!
//! ```text
//! y' = f(t, y),  y(T; y_0) = y_0,   M = dy(T)/dy_0:        [M - 1     f(y_T)] [dy_0]     [y_T - y_0]
//! without drive T is an unknown, and dy_0 . f(y_0) = 0:    [f(y_0)^T    0   ] [ dT ] = - [    0    ]
//! multipliers: the eigenvalues of M;                       the orbit attracts where all lie inside the unit circle
//! ```
//!
//! The guess only begins the search: the orbit found depends on the equation alone, and may be
//! stable or not. Orbits that are known already are avoided by deflation (P. E. Farrell, A.
//! Birkisson, S. W. Funke, SIAM J. Sci. Comput. 37, 2015, A2026):
//!
//! ```text
//! Newton on  eta(y) (y(T) - y),  eta = product of (1 + 1/|y - y_known|^2):  the step of Newton's method over 1 - (grad eta . step)/eta
//! ```

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use num_complex::Complex;

use crate::numeric::ode::{IntegrationOptions, State, Trajectory, integrate};

/// An orbit of N states that comes back to its start after a period.
#[derive(Clone, Debug)]
pub struct PeriodicOrbit<const N: usize = 2, Path = Trajectory> {
    /// The state at the beginning of the period.
    pub start: [f64; N],
    /// The period.
    pub period: f64,
    /// The monodromy matrix: the derivative of the state after a period by the state at its
    /// beginning.
    pub monodromy: SMatrix<f64, N, N>,
    /// The orbit as it was followed over a period.
    pub path: Path,
}

impl<const N: usize, Path> PeriodicOrbit<N, Path> {
    /// The Floquet multipliers, the eigenvalues of the monodromy matrix. Without drive one of them
    /// is 1, along the orbit.
    pub fn multipliers(&self) -> Vec<Complex<f64>> {
        let matrix = self.monodromy.resize(N, N, 0.0);
        match N {
            2 => eigenvalues_of_two(matrix.trace(), matrix.determinant()).into(),
            _ => matrix.complex_eigenvalues().iter().copied().collect(),
        }
    }

    /// Whether neighbouring motions approach the orbit: all multipliers lie inside the unit circle.
    pub fn attracts(&self) -> bool {
        self.multipliers().iter().all(|value| value.norm() < 1.0)
    }
}

impl PeriodicOrbit {
    /// Position and velocity at a time between zero and the period.
    pub fn phase_point_at(&self, t: f64) -> (f64, f64) {
        self.path.phase_point_at(t).unwrap_or((f64::NAN, f64::NAN))
    }

    /// Returns the amplitude of a harmonic of the orbit, `sqrt(c^2 + s^2)` of its cosine and sine.
    pub fn harmonic(&self, number: u32) -> f64 {
        const SAMPLES: usize = 4096;
        let sample = |k: usize| {
            let part = k as f64 / SAMPLES as f64;
            let x = self.phase_point_at(part * self.period).0;
            let angle = TAU * f64::from(number) * part;
            (x * angle.cos(), x * angle.sin())
        };
        let sum = (0..SAMPLES).map(sample).fold((0.0, 0.0), |sum, (c, s)| (sum.0 + c, sum.1 + s));
        2.0 * sum.0.hypot(sum.1) / SAMPLES as f64
    }
}

/// Returns the eigenvalues of a 2 by 2 matrix, the larger first, from its trace and its
/// determinant.
pub fn eigenvalues_of_two(trace: f64, determinant: f64) -> [Complex<f64>; 2] {
    let half = 0.5 * trace;
    let square = half * half - determinant;
    if square < 0.0 {
        let root = (-square).sqrt();
        return [Complex::new(half, root), Complex::new(half, -root)];
    }
    // The smaller one by the product, which does not cancel.
    let large = half + half.signum() * square.sqrt();
    let small = if large == 0.0 { 0.0 } else { determinant / large };
    [large, small].map(Complex::from)
}

/// A search for a periodic orbit near a guess.
pub struct Shooting<'a, const N: usize> {
    /// The state from which the search begins.
    pub guess: [f64; N],
    /// The period; only a guess of it if `rates` are given.
    pub period: f64,
    /// The rates of a state under autonomous equations, for which the period is an unknown; `None`
    /// for driven equations.
    pub rates: Option<&'a dyn Fn([f64; N]) -> [f64; N]>,
    /// The positive size in which each state is measured.
    pub sizes: [f64; N],
    /// Solves the linear equations of a step. If there is an orbit of every amplitude the matrix is
    /// singular, and the solution of least norm leads to the nearest orbit.
    pub solve: fn(DMatrix<f64>, DVector<f64>) -> Option<DVector<f64>>,
    /// Largest number of Newton steps.
    pub most: usize,
    /// Largest change of the start, in units of the sizes, and of the period, in units of its
    /// guess.
    pub far: f64,
    /// The starts of known orbits, which the search avoids.
    pub known: &'a [[f64; N]],
}

impl<const N: usize> Shooting<'_, N> {
    /// Returns the orbit; `None` if a motion cannot be followed over a period, or Newton's method
    /// does not converge. `follow` returns the state after a period from a start, its derivative by
    /// the start and the path; `settled` is called with the distance of an orbit from closing and
    /// the step of Newton's method, both in units of the sizes, and returns whether it has
    /// converged.
    pub fn orbit<Path>(
        &self,
        mut follow: impl FnMut([f64; N], f64) -> Option<([f64; N], SMatrix<f64, N, N>, Path)>,
        mut settled: impl FnMut(f64, f64) -> bool,
    ) -> Option<PeriodicOrbit<N, Path>> {
        let mut search = self.begin();
        loop {
            let image = follow(search.start(), search.period())?;
            match search.advance(image, &mut settled) {
                SearchStep::Found(orbit) => return Some(orbit),
                SearchStep::Going => {}
                SearchStep::Failed => return None,
            }
        }
    }

    /// The search before its first step, for those who follow several motions side by side.
    pub fn begin(&self) -> OrbitSearch<'_, N> {
        let [start, sizes] = [self.guess, self.sizes].map(SVector::from);
        OrbitSearch { shooting: self, sizes, start, period: self.period, steps: 0 }
    }
}

/// A search for a periodic orbit, step by step.
pub struct OrbitSearch<'a, const N: usize> {
    shooting: &'a Shooting<'a, N>,
    sizes: SVector<f64, N>,
    start: SVector<f64, N>,
    period: f64,
    /// The number of steps taken.
    steps: usize,
}

/// The result of a step of a search.
pub enum SearchStep<const N: usize, Path> {
    /// Newton's method has converged.
    Found(PeriodicOrbit<N, Path>),
    /// Another motion is to be followed.
    Going,
    /// Newton's method does not converge.
    Failed,
}

impl<const N: usize> OrbitSearch<'_, N> {
    /// The start of the next motion to be followed.
    pub fn start(&self) -> [f64; N] {
        self.start.into()
    }

    /// The time over which it is to be followed.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Takes a step of Newton's method from the motion that was followed: the state after a period,
    /// its derivative by the start, and the path. `settled` is that of [`Shooting::orbit`].
    pub fn advance<Path>(
        &mut self,
        (end, monodromy, path): ([f64; N], SMatrix<f64, N, N>, Path),
        settled: &mut impl FnMut(f64, f64) -> bool,
    ) -> SearchStep<N, Path> {
        match self.advanced(end, monodromy, settled) {
            Some(true) => SearchStep::Found(PeriodicOrbit {
                start: self.start.into(),
                period: self.period,
                monodromy,
                path,
            }),
            Some(false) if self.steps < self.shooting.most => SearchStep::Going,
            _ => SearchStep::Failed,
        }
    }

    /// Takes a step, unless the search has converged, which is returned; `None` if there is no
    /// step, or it leads too far.
    fn advanced(
        &mut self,
        end: [f64; N],
        monodromy: SMatrix<f64, N, N>,
        settled: &mut impl FnMut(f64, f64) -> bool,
    ) -> Option<bool> {
        /// The longest step, in units of the sizes: a longer one leads to another orbit, or
        /// nowhere.
        const LONGEST: f64 = 0.5;
        let (shooting, start, period) = (self.shooting, self.start, self.period);
        let sizes = self.sizes;
        let in_sizes = |vector: SVector<f64, N>| vector.component_div(&sizes);
        let length = |vector| in_sizes(vector).iter().copied().fold(0.0, f64::hypot);
        self.steps += 1;
        let missed = SVector::from(end) - start;
        let matrix = monodromy - SMatrix::identity();
        let (step, longer) = match shooting.rates {
            None => {
                let missed = missed.resize_vertically(N, 0.0);
                let step = (shooting.solve)(matrix.resize(N, N, 0.0), missed)?;
                (step.fixed_rows::<N>(0).into_owned(), 0.0)
            }
            Some(rates) => {
                let [there, back] =
                    [start.into(), end].map(|state| in_sizes(SVector::from(rates(state)) * period));
                let matrix = DMatrix::from_fn(N + 1, N + 1, |i, j| match (i < N, j < N) {
                    (true, true) if i == j => matrix[(i, i)],
                    (true, true) => matrix[(i, j)] * sizes[j] / sizes[i],
                    (true, false) => back[i],
                    (false, true) => there[j],
                    (false, false) => 0.0,
                });
                let missed = in_sizes(missed).resize_vertically(N + 1, 0.0);
                let step = (shooting.solve)(matrix, missed)?;
                (step.fixed_rows::<N>(0).component_mul(&sizes), step[N])
            }
        };
        // grad eta . step over eta
        let pull = |known: &[f64; N]| {
            let apart = in_sizes(start - SVector::from(*known));
            let square = apart.norm_squared();
            -2.0 * in_sizes(apart.component_mul(&step)).sum() / (square * (square + 1.0))
        };
        let step = step / (1.0 + shooting.known.iter().map(pull).sum::<f64>());
        let moved = length(step).hypot(longer);
        if settled(length(missed), moved) {
            return Some(true);
        }
        let part = f64::min(1.0, LONGEST / moved);
        self.start -= step * part;
        self.period *= 1.0 - part * longer;
        let guess = SVector::from(shooting.guess);
        let is_near = length(self.start - guess) <= shooting.far
            && (self.period / shooting.period - 1.0).abs() <= shooting.far;
        is_near.then_some(false)
    }
}

/// Returns the triple that `follow` of [`Shooting::orbit`] returns, with the derivative by central
/// differences: here `follow` returns only the state after a period from a start, and the path;
/// `sizes` are the sizes of the states.
pub fn by_differences<const N: usize, Path>(
    start: [f64; N],
    sizes: [f64; N],
    mut follow: impl FnMut([f64; N]) -> Option<([f64; N], Path)>,
) -> Option<([f64; N], SMatrix<f64, N, N>, Path)> {
    /// Step of the differences over the size of a state, far above the error of integration.
    const DIFFERENCE: f64 = 1e-5;
    let (end, path) = follow(start)?;
    let mut derivative = SMatrix::<f64, N, N>::zeros();
    for (index, size) in sizes.into_iter().enumerate() {
        let step = DIFFERENCE * size;
        let mut beside = |step: f64| {
            let mut start = start;
            start[index] += step;
            Some(SVector::from(follow(start)?.0))
        };
        let difference = beside(step)? - beside(-step)?;
        derivative.set_column(index, &(difference / (2.0 * step)));
    }
    Some((end, derivative, path))
}

/// Returns the periodic motion of `x'' = acceleration(t, x, x')`, which has this period in `t`,
/// near a start, given by position and velocity at `t = 0`. Motions that begin at the known starts
/// are avoided; `size` is the approximate amplitude. Returns `None` if no motion is found, or it
/// cannot be followed.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::periodic::periodic_motion;
///
/// // x'' + x'/5 + x = cos(2t)
/// let acceleration = |t: f64, x: f64, v: f64| (2.0 * t).cos() - x - 0.2 * v;
/// let found = periodic_motion(&acceleration, std::f64::consts::PI, [0.0, 0.0], 1.0, &[]).ok_or("none")?;
/// assert!((found.harmonic(1) - 1.0 / 9.16_f64.sqrt()).abs() < 1e-9 && found.attracts());
/// # Ok::<(), &str>(())
/// ```
pub fn periodic_motion(
    acceleration: &dyn Fn(f64, f64, f64) -> f64,
    period: f64,
    guess: [f64; 2],
    size: f64,
    known: &[[f64; 2]],
) -> Option<PeriodicOrbit> {
    /// Relative size of a step below which Newton's method has converged.
    const SETTLED: f64 = 1e-11;
    let (sizes, far) = ([size, size * (TAU / period)], f64::INFINITY);
    let options = IntegrationOptions {
        absolute_tolerance: 1e-13 * size,
        ..IntegrationOptions::with_tolerance(1e-12)
    };
    let follow = |[x, v]: [f64; 2]| {
        let path = integrate(acceleration, State { t: 0.0, x, v }, period, &[], &options).ok()?;
        path.is_complete().then(|| ([path.end().x, path.end().v], path))
    };
    let mut before = f64::INFINITY;
    let settled = |_, moved| std::mem::replace(&mut before, moved) < SETTLED;
    let solve = |matrix: DMatrix<f64>, missed| Some(matrix.try_inverse()? * missed);
    Shooting { guess, period, rates: None, sizes, solve, most: 31, far, known }
        .orbit(|start, _| by_differences(start, sizes, follow), settled)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::ode::{Point, integrate_first_order};

    /// `x'' + D x' + K x`, two masses coupled by springs and dampers.
    const STIFFNESS: [[f64; 2]; 2] = [[3.0, -1.0], [-1.0, 2.0]];
    const DAMPING: [[f64; 2]; 2] = [[0.3, -0.1], [-0.1, 0.2]];

    /// y' = A y for the positions, then the velocities.
    fn matrix() -> SMatrix<f64, 4, 4> {
        SMatrix::from_fn(|row, column| match (row, column) {
            (0 | 1, _) => f64::from(u8::from(column == row + 2)),
            (_, 0 | 1) => -STIFFNESS[row - 2][column],
            _ => -DAMPING[row - 2][column - 2],
        })
    }

    /// The two masses, the first of them driven by `force * cos(omega t)`.
    fn coupled(force: f64, omega: f64) -> PeriodicOrbit<4, ()> {
        let matrix = matrix();
        let rates = |t: f64, y: &[f64; 4], rates: &mut [f64; 4]| {
            *rates = (matrix * SVector::from(*y)).into();
            rates[2] += force * (omega * t).cos();
        };
        let (guess, period, sizes) = ([0.2; 4], TAU / omega, [1.0; 4]);
        let follow = |start: [f64; 4]| {
            let options = IntegrationOptions::with_tolerance(1e-12);
            let begin = Point { t: 0.0, y: start };
            let path = integrate_first_order(rates, begin, period, &[], &options).ok()?;
            Some((path.end().y, ()))
        };
        let solve = |matrix: DMatrix<f64>, missed| matrix.lu().solve(&missed);
        Shooting { guess, period, rates: None, sizes, solve, most: 10, far: 10.0, known: &[] }
            .orbit(|start, _| by_differences(start, sizes, follow), |_, moved| moved < 1e-10)
            .expect("an orbit")
    }

    /// `x = Re (K - omega^2 + i omega D)^(-1) (force, 0) exp(i omega t)`.
    #[test]
    fn two_coupled_oscillators_come_back_where_their_exact_motion_does() {
        for (force, omega) in [(1.0, 0.7), (2.0, 1.4), (0.3, 3.0)] {
            let orbit = coupled(force, omega);
            let dynamic = SMatrix::<_, 2, 2>::from_fn(|row, column| {
                let inertia = if row == column { omega * omega } else { 0.0 };
                Complex::new(STIFFNESS[row][column] - inertia, omega * DAMPING[row][column])
            });
            let drive = SVector::from([force, 0.0].map(Complex::from));
            let exact = dynamic.lu().solve(&drive).expect("off resonance");
            for (index, amplitude) in exact.iter().enumerate() {
                let velocity = Complex::i() * omega * amplitude;
                assert!((orbit.start[index] - amplitude.re).abs() < 1e-9, "{omega}: {orbit:?}");
                assert!((orbit.start[index + 2] - velocity.re).abs() < 1e-9, "{omega}: {orbit:?}");
            }
        }
    }

    /// M = exp(A T), by its series after halvings of T.
    #[test]
    fn the_multipliers_are_those_of_the_matrix_exponential() {
        for omega in [0.7, 1.4, 3.0] {
            let (orbit, period) = (coupled(1.0, omega), TAU / omega);
            let small = matrix() * (period / 1024.0);
            let (mut term, mut exact) = (SMatrix::identity(), SMatrix::identity());
            for power in 1..12 {
                term = term * small / f64::from(power);
                exact += term;
            }
            for _ in 0..10 {
                exact *= exact;
            }
            assert!((orbit.monodromy - exact).amax() < 1e-8, "{}", orbit.monodromy);
            let rates = matrix().complex_eigenvalues();
            for value in orbit.multipliers() {
                let apart = rates.iter().map(|rate| (value - (rate * period).exp()).norm());
                assert!(apart.fold(f64::INFINITY, f64::min) < 1e-7, "{value} {rates}");
            }
            assert!(orbit.attracts() && orbit.multipliers().len() == 4);
        }
    }

    /// Two oscillators of van der Pol, the second drawn to the first: four states, of which the
    /// period is not known, and one multiplier is 1.
    #[test]
    fn a_limit_cycle_of_four_states_has_its_period() {
        let rates = |[x, y, v, w]: [f64; 4]| {
            [v, w, (1.0 - x * x) * v - x, (1.0 - y * y) * w - y + 0.5 * (x - y)]
        };
        let (guess, sizes) = ([2.0, 2.0, 0.0, 0.0], [2.0; 4]);
        let follow = |start: [f64; 4], period: f64| {
            let options = IntegrationOptions::with_tolerance(1e-12);
            let in_time = |_: f64, y: &[f64; 4], out: &mut [f64; 4]| *out = rates(*y);
            let begin = Point { t: 0.0, y: start };
            let path = integrate_first_order(in_time, begin, period, &[], &options).ok()?;
            Some((path.end().y, ()))
        };
        let shooting = Shooting {
            guess,
            period: 6.6,
            rates: Some(&rates),
            sizes,
            solve: |matrix, missed| matrix.svd(true, true).solve(&missed, 1e-9).ok(),
            most: 20,
            far: 0.5,
            known: &[],
        };
        let orbit = shooting
            .orbit(
                |start, period| by_differences(start, sizes, |start| follow(start, period)),
                |_, moved| moved < 1e-9,
            )
            .expect("a cycle");
        assert!((orbit.period - 6.663_286_859_3).abs() < 1e-8, "{}", orbit.period);
        assert!((orbit.start[0] - orbit.start[1]).abs() < 1e-8, "{orbit:?}");
        let along = orbit.multipliers().into_iter().map(|value| (value - 1.0).norm());
        assert!(along.fold(f64::INFINITY, f64::min) < 1e-6, "{:?}", orbit.multipliers());
    }
}

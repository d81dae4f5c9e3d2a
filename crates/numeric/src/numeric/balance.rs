//! Harmonic balance of any number of coordinates with many harmonics: the equations of a periodic
//! motion as equations for its Fourier coefficients.
//!
//! ```text
//! X_i(theta) = a_i0 + sum_(k = 1..H) a_ik cos(k theta) + b_ik sin(k theta),   i = 1..n
//! u = (a_10, a_11, b_11, ..., a_1H, b_1H, a_20, ..., b_nH)
//! R(u, p) = the same coefficients of omega^2 X'' + f(X, omega X', theta; p)
//! ```
//!
//! The forces are sampled at equal steps of the phase and transformed back into harmonics, the
//! alternating frequency-time method (T. M. Cameron and J. H. Griffin, *J. Appl. Mech.* 56 (1989)
//! 149; G. von Groll and D. J. Ewins, *J. Sound Vib.* 241 (2001) 223; M. Krack and J. Gross,
//! *Harmonic Balance for Nonlinear Vibration Problems*, Springer 2019). The Jacobian comes from the
//! harmonics of the derivatives of the forces at the same samples. In: coefficients, and the forces
//! as a closure. Out: residual and derivatives, in the units of the equations.
//!
//! Samples do not show where a force jumps. The caller adds the surplus of the force on one side of
//! the jump, as integrals at phases that it has located: [`LocatedForces`].
//!
//! Without a drive the frequency of a motion is an unknown, and the time at which it begins is
//! free: it begins where the first sine of one coordinate is zero, and the frequency takes the
//! place of that sine among the unknowns.
//!
//! ```
//! # use lindstedt_numeric as lindstedt;
//! use lindstedt::numeric::balance::{ForceSample, HarmonicBalance, LocatedForces};
//! use nalgebra::DVector;
//!
//! // x'' + 4x = y + cos t, y'' + 4y = x: x = 3/8 cos t, y = 1/8 cos t
//! let force = |phase: f64, state: &[[f64; 2]], sample: &mut ForceSample| {
//!     let [x, y] = [state[0][0], state[1][0]];
//!     sample.value.copy_from_slice(&[4.0 * x - y - phase.cos(), 4.0 * y - x]);
//!     sample.by_position.copy_from_slice(&[4.0, -1.0, -1.0, 4.0]);
//! };
//! let balance = HarmonicBalance::new(2, 1, true, None);
//! let equations = |u: &DVector<f64>| balance.linearised(&balance.motion(u), [1.0, 0.0], LocatedForces::default(), force);
//! let found = balance.solve(&DVector::zeros(balance.size()), equations).ok_or("none")?;
//! assert!((balance.harmonic(&found, 0, 1)[0] - 0.375).abs() < 1e-14);
//! assert!((balance.harmonic(&found, 1, 1)[0] - 0.125).abs() < 1e-14);
//! # Ok::<(), &str>(())
//! ```

use std::cell::Cell;
use std::f64::consts::TAU;

use nalgebra::{DMatrix, DMatrixViewMut, DVector};

use super::harmonics::{Harmonics, Transform};
use super::ode::newton::{Progress, newton};

/// Samples per harmonic, and the least number of samples: forces up to the seventh power are exact.
const SMOOTH: [usize; 2] = [8, 32];

/// Samples per harmonic, and the least number of samples, for forces with corners: with fewer the
/// branch would waver as a corner moves from sample to sample.
const CORNERED: [usize; 2] = [32, 512];

/// Relative size of a step of Newton's method below which it has converged.
pub const CONVERGED: f64 = 1e-10;

/// The harmonic balance equations of n coordinates with H harmonics.
#[derive(Clone, Debug)]
pub struct HarmonicBalance {
    /// n: the number of coordinates.
    pub coordinates: usize,
    /// H: the highest harmonic.
    pub harmonics: usize,
    /// The coordinate whose first sine is zero, where nothing drives the motion: the frequency
    /// stands in the place of that sine among the unknowns.
    pub anchor: Option<usize>,
    /// The transform from samples to harmonics and back; the number of samples is a power of two.
    transform: Transform,
}

/// The forces at a phase, one on each coordinate, and their derivatives; row i belongs to f_i.
#[derive(Clone, Debug)]
pub struct ForceSample {
    /// The forces f_i.
    pub value: DVector<f64>,
    /// The derivative of f_i by the position of coordinate j.
    pub by_position: DMatrix<f64>,
    /// The derivative of f_i by the velocity of coordinate j.
    pub by_velocity: DMatrix<f64>,
    /// The derivative of f_i by the parameter, the phase being fixed.
    pub by_parameter: DVector<f64>,
}

/// Forces that act at single phases, in addition to those at the samples.
#[derive(Clone, Debug, Default)]
pub struct LocatedForces {
    phases: Vec<f64>,
    /// For each phase the rows of [`ForceSample::write_row`], coordinate by coordinate.
    rows: Vec<f64>,
}

/// The forces at every sample of a motion, and their derivatives: columns for each coordinate, one for
/// each [`ForceColumn`].
#[derive(Clone, Debug)]
pub struct SampledForces {
    coordinates: usize,
    columns: DMatrix<f64>,
}

/// A quantity of [`SampledForces`], of one coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceColumn {
    /// The force.
    Value,
    /// Its derivative by the position of a coordinate.
    ByPosition(usize),
    /// Its derivative by the velocity of a coordinate.
    ByVelocity(usize),
    /// Its derivative by the parameter, the phase being fixed.
    ByParameter,
}

/// The residual and its derivatives at a point.
#[derive(Clone, Debug)]
pub struct Linearised {
    /// The residual R.
    pub residual: DVector<f64>,
    /// dR/du, with dR/dp as the last column.
    pub jacobian: DMatrix<f64>,
    /// The size of the terms that cancel in R.
    pub scale: f64,
}

impl ForceSample {
    /// A sample of zero forces on this many coordinates.
    pub fn zeros(coordinates: usize) -> Self {
        Self {
            value: DVector::zeros(coordinates),
            by_position: DMatrix::zeros(coordinates, coordinates),
            by_velocity: DMatrix::zeros(coordinates, coordinates),
            by_parameter: DVector::zeros(coordinates),
        }
    }

    /// Calls `write` with the index and the value of each column of row i: f_i, its derivatives by
    /// n positions, by n velocities and by the parameter, and last `by_frequency`.
    fn write_row(&self, i: usize, by_frequency: f64, mut write: impl FnMut(usize, f64)) {
        let n = self.value.len();
        write(0, self.value[i]);
        for j in 0..n {
            write(1 + j, self.by_position[(i, j)]);
            write(1 + n + j, self.by_velocity[(i, j)]);
        }
        write(2 * n + 1, self.by_parameter[i]);
        write(2 * n + 2, by_frequency);
    }
}

impl SampledForces {
    /// No forces at the samples of a balance.
    pub fn zeros(balance: &HarmonicBalance) -> Self {
        let coordinates = balance.coordinates;
        let columns = DMatrix::zeros(balance.samples(), coordinates * balance.width());
        Self { coordinates, columns }
    }

    /// The values at all samples of a quantity of a coordinate.
    pub fn column_mut(&mut self, coordinate: usize, column: ForceColumn) -> &mut [f64] {
        let (n, samples) = (self.coordinates, self.columns.nrows());
        let place = coordinate * (2 * n + 3)
            + match column {
                ForceColumn::Value => 0,
                ForceColumn::ByPosition(j) => 1 + j,
                ForceColumn::ByVelocity(j) => 1 + n + j,
                ForceColumn::ByParameter => 2 * n + 1,
            };
        &mut self.columns.as_mut_slice()[place * samples..][..samples]
    }
}

impl LocatedForces {
    /// Adds forces at a phase, given by the integrals over the phase of themselves and of their
    /// derivatives, and the velocities there.
    pub fn push(&mut self, phase: f64, velocities: &[f64], integral: &ForceSample) {
        self.phases.push(phase);
        for i in 0..velocities.len() {
            let products = velocities.iter().enumerate();
            let products = products.map(|(j, velocity)| integral.by_velocity[(i, j)] * velocity);
            // The derivative by the frequency, times the frequency: `linearised` divides by it.
            let first = self.rows.len();
            self.rows.resize(first + 2 * velocities.len() + 3, 0.0);
            integral
                .write_row(i, products.sum(), |column, value| self.rows[first + column] = value);
        }
    }
}

impl HarmonicBalance {
    /// The equations of `coordinates` coordinates with `harmonics` harmonics, one at least;
    /// `smooth` says that the forces have no corners, `anchor` which first sine is zero if the
    /// frequency is unknown.
    pub fn new(coordinates: usize, harmonics: usize, smooth: bool, anchor: Option<usize>) -> Self {
        let harmonics = harmonics.max(1);
        let [each, least] = if smooth { SMOOTH } else { CORNERED };
        let samples = (each * (harmonics + 1)).next_power_of_two().max(least);
        Self { coordinates, harmonics, anchor, transform: Transform::new(samples) }
    }

    /// The number of unknowns of a coordinate: 2 H + 1.
    fn block(&self) -> usize {
        2 * self.harmonics + 1
    }

    /// The number of columns of a force and its derivatives: itself, n positions, n velocities, the
    /// parameter and the frequency.
    fn width(&self) -> usize {
        2 * self.coordinates + 3
    }

    /// The number of unknowns: n (2 H + 1).
    pub fn size(&self) -> usize {
        self.coordinates * self.block()
    }

    /// The number of samples.
    pub fn samples(&self) -> usize {
        self.transform.samples()
    }

    /// Returns the index of the frequency among the unknowns, where b_1 of the anchor would stand;
    /// `None` if the frequency is given.
    pub fn frequency_place(&self) -> Option<usize> {
        Some(self.anchor? * self.block() + 2)
    }

    /// Returns the angular frequency of a motion: the one among the unknowns, or `given` if there
    /// is none.
    pub fn frequency(&self, unknowns: &DVector<f64>, given: f64) -> f64 {
        self.frequency_place().map_or(given, |place| unknowns[place])
    }

    /// Returns the coefficients of cosine and sine of every harmonic of a coordinate; the first
    /// pair is the mean and zero.
    pub fn waves(
        &self,
        unknowns: &DVector<f64>,
        coordinate: usize,
    ) -> impl Iterator<Item = [f64; 2]> {
        let own = &unknowns.as_slice()[coordinate * self.block()..][..self.block()];
        let anchored = self.anchor == Some(coordinate);
        let wave = move |(index, wave): (usize, &[f64])| match index {
            0 if anchored => [wave[0], 0.0],
            _ => [wave[0], wave[1]],
        };
        [[own[0], 0.0]].into_iter().chain(own[1..].chunks_exact(2).enumerate().map(wave))
    }

    /// Returns the coefficients of cosine and sine of one harmonic of a coordinate, as in
    /// [`HarmonicBalance::waves`]; zero beyond the last.
    pub fn harmonic(
        &self,
        unknowns: &DVector<f64>,
        coordinate: usize,
        harmonic: usize,
    ) -> [f64; 2] {
        self.waves(unknowns, coordinate).nth(harmonic).unwrap_or_default()
    }

    /// Returns the size of a motion about its mean: the norm of the coefficients of all harmonics.
    pub fn extent(&self, unknowns: &DVector<f64>) -> f64 {
        let waves = |coordinate: usize| {
            let first = coordinate * self.block() + 1;
            let norm = |skipped: usize| {
                unknowns.rows(first + skipped, 2 * self.harmonics - skipped).norm()
            };
            match self.anchor == Some(coordinate) {
                true => unknowns[first].hypot(norm(2)),
                false => norm(0),
            }
        };
        (0..self.coordinates).map(waves).fold(0.0, f64::hypot)
    }

    /// Returns the norm of the coefficients of the last quarter of the harmonics.
    pub fn last_harmonics(&self, unknowns: &DVector<f64>) -> f64 {
        let first = self.harmonics - self.harmonics / 4;
        let last = |coordinate| {
            let waves = self.waves(unknowns, coordinate).skip(first + 1);
            waves.map(|[cosine, sine]| cosine.hypot(sine))
        };
        (0..self.coordinates).flat_map(last).fold(0.0, f64::hypot)
    }

    /// Returns X_i and its first and second derivative by the phase, at every sample, for each
    /// coordinate.
    pub fn motion(&self, unknowns: &DVector<f64>) -> Vec<Vec<[f64; 3]>> {
        let of_coordinate = |coordinate: usize| {
            let derivative = |times: u32| {
                let wave = move |(harmonic, [a, b]): (usize, [f64; 2])| {
                    let k = harmonic as f64;
                    match times {
                        0 => [a, b],
                        1 => [k * b, -k * a],
                        _ => [-k * k * a, -k * k * b],
                    }
                };
                self.waves(unknowns, coordinate).enumerate().map(wave)
            };
            let pairs = self.transform.sums_of_waves(derivative(0), derivative(1));
            let curvatures = self.transform.sum_of_waves(derivative(2));
            let points = pairs.into_iter().zip(curvatures);
            points.map(|([position, slope], curvature)| [position, slope, curvature]).collect()
        };
        (0..self.coordinates).map(of_coordinate).collect()
    }

    /// Position and velocity of a coordinate at a phase of a motion of this frequency.
    pub fn at(
        &self,
        unknowns: &DVector<f64>,
        coordinate: usize,
        omega: f64,
        phase: f64,
    ) -> [f64; 2] {
        let mut point = [unknowns[coordinate * self.block()], 0.0];
        let (step_sine, step_cosine) = phase.sin_cos();
        let (mut cosine, mut sine) = (1.0, 0.0);
        for (harmonic, [a, b]) in self.waves(unknowns, coordinate).enumerate().skip(1) {
            (cosine, sine) =
                (cosine * step_cosine - sine * step_sine, sine * step_cosine + cosine * step_sine);
            point[0] += a * cosine + b * sine;
            point[1] += omega * harmonic as f64 * (b * cosine - a * sine);
        }
        point
    }

    /// Returns the second derivative of X_i by the phase.
    pub fn curvature(&self, unknowns: &DVector<f64>, coordinate: usize, phase: f64) -> f64 {
        let term = |(harmonic, [a, b]): (usize, [f64; 2])| {
            let k = harmonic as f64;
            let (sine, cosine) = (k * phase).sin_cos();
            -k * k * (a * cosine + b * sine)
        };
        self.waves(unknowns, coordinate).enumerate().skip(1).map(term).sum()
    }

    /// The coefficients of a motion whose coordinates are known at any number of equal steps of a
    /// period, twice as many as harmonics at least.
    pub fn coefficients_of(&self, positions: &[&[f64]]) -> DVector<f64> {
        let of_coordinate = |positions: &&[f64]| {
            let count = positions.len().max(1);
            let step = TAU / count as f64;
            let waves: Vec<(f64, f64)> =
                (0..count).map(|index| (step * index as f64).sin_cos()).collect();
            let harmonic = |harmonic: usize| {
                let mut sums = (0.0, 0.0);
                let mut place = 0;
                for value in *positions {
                    let (sine, cosine) = waves[place];
                    sums = (sums.0 + value * cosine, sums.1 + value * sine);
                    place = (place + harmonic) % count;
                }
                (2.0 * sums.0 / count as f64, 2.0 * sums.1 / count as f64)
            };
            let (cosines, sines) = (0..=self.harmonics).map(harmonic).unzip();
            Harmonics { cosines, sines }
        };
        self.in_order(positions.iter().map(of_coordinate))
    }

    /// The coefficients of a motion whose coordinates are known at the samples of a transform, twice
    /// as many as harmonics at least.
    pub fn transformed(&self, transform: &Transform, positions: &[&[f64]]) -> DVector<f64> {
        let harmonics = |positions: &&[f64]| transform.harmonics(positions, self.harmonics);
        self.in_order(positions.iter().map(harmonics))
    }

    /// The unknowns of a motion of this frequency, whose coordinates are known as in
    /// [`HarmonicBalance::coefficients_of`].
    pub fn unknowns_of(&self, positions: &[&[f64]], frequency: f64) -> DVector<f64> {
        let coefficients = self.coefficients_of(positions);
        let Some(place) = self.frequency_place() else {
            return coefficients;
        };
        let begun = coefficients[place].atan2(coefficients[place - 1]);
        let mut unknowns = self.later(&coefficients, begun);
        unknowns[place] = frequency;
        unknowns
    }

    /// Returns the coefficients of the same motion begun later by `phase`.
    pub fn later(&self, coefficients: &DVector<f64>, phase: f64) -> DVector<f64> {
        let mut turned = coefficients.clone();
        for harmonic in 1..=self.harmonics {
            let (sine, cosine) = (phase * harmonic as f64).sin_cos();
            for first in (0..self.size()).step_by(self.block()) {
                let place = first + 2 * harmonic;
                let (a, b) = (coefficients[place - 1], coefficients[place]);
                turned[place - 1] = a * cosine + b * sine;
                turned[place] = b * cosine - a * sine;
            }
        }
        turned
    }

    /// Arranges the coefficients of each coordinate in the order of the unknowns.
    fn in_order(&self, harmonics: impl Iterator<Item = Harmonics>) -> DVector<f64> {
        let mut all = Vec::with_capacity(self.size());
        for Harmonics { cosines, sines } in harmonics {
            all.push(0.5 * cosines[0]);
            for (cosine, sine) in cosines[1..=self.harmonics].iter().zip(&sines[1..]) {
                all.extend([*cosine, *sine]);
            }
        }
        DVector::from_vec(all)
    }

    /// The residual and its derivatives on a motion, given by [`HarmonicBalance::motion`] and by
    /// its frequency, with the derivative of that by the parameter. `force` is called with a phase
    /// and the position and velocity of each coordinate, and writes the forces there; entries that
    /// it never writes are zero; `located` is added to them. `None` if some force has no finite
    /// value on the motion.
    pub fn linearised(
        &self,
        motion: &[Vec<[f64; 3]>],
        [omega, omega_slope]: [f64; 2],
        located: LocatedForces,
        mut force: impl FnMut(f64, &[[f64; 2]], &mut ForceSample),
    ) -> Option<Linearised> {
        if omega.is_nan() || omega <= 0.0 {
            return None;
        }
        let (n, width) = (self.coordinates, self.width());
        let mut forces = SampledForces::zeros(self);
        let mut sample = ForceSample::zeros(n);
        let mut state = vec![[0.0; 2]; n];
        let step = TAU / self.samples() as f64;
        for index in 0..self.samples() {
            for (state, motion) in state.iter_mut().zip(motion) {
                let [position, by_phase, _] = motion[index];
                *state = [position, omega * by_phase];
            }
            force(step * index as f64, &state, &mut sample);
            for i in 0..n {
                sample.write_row(i, 0.0, |column, value| {
                    forces.columns[(index, i * width + column)] = value;
                });
            }
        }
        self.linearised_on(motion, [omega, omega_slope], located, forces)
    }

    /// The residual and its derivatives on a motion, from the forces at all of its samples, otherwise
    /// as [`HarmonicBalance::linearised`].
    pub fn linearised_on(
        &self,
        motion: &[Vec<[f64; 3]>],
        [omega, omega_slope]: [f64; 2],
        mut located: LocatedForces,
        SampledForces { columns: mut sampled, .. }: SampledForces,
    ) -> Option<Linearised> {
        if omega.is_nan() || omega <= 0.0 {
            return None;
        }
        let (n, samples, width) = (self.coordinates, self.samples(), self.width());
        let mut scale = 0.0_f64;
        let mut by_frequency = vec![0.0; samples];
        for i in 0..n {
            let columns = &mut sampled.as_mut_slice()[i * width * samples..][..width * samples];
            for (sum, [_, _, curvature]) in by_frequency.iter_mut().zip(&motion[i]) {
                *sum = 2.0 * omega * curvature;
            }
            for (j, motion) in motion.iter().enumerate() {
                let by_velocity = &columns[(1 + n + j) * samples..][..samples];
                let terms = by_frequency.iter_mut().zip(by_velocity).zip(motion);
                terms.for_each(|((sum, slope), [_, by_phase, _])| *sum += slope * by_phase);
            }
            for (value, [_, _, curvature]) in columns.iter_mut().zip(&motion[i]) {
                let inertia = omega * omega * curvature;
                scale = scale.max(inertia.abs()).max(value.abs());
                *value += inertia;
            }
            let last = columns[(2 * n + 1) * samples..].iter_mut().zip(&by_frequency);
            last.for_each(|(by_parameter, term)| *by_parameter += omega_slope * term);
            columns[(2 * n + 2) * samples..].copy_from_slice(&by_frequency);
        }
        for row in located.rows.chunks_exact_mut(width) {
            row[2 * n + 2] /= omega;
            row[2 * n + 1] += omega_slope * row[2 * n + 2];
        }
        if !sampled.iter().chain(&located.rows).all(|value| value.is_finite()) {
            return None;
        }
        let spectrum = |i: usize, column: usize, count: usize| {
            let place = i * width + column;
            let mut harmonics = self.transform.harmonics(sampled.column(place).as_slice(), count);
            for (phase, row) in located.phases.iter().zip(located.rows.chunks_exact(n * width)) {
                harmonics.add(*phase, row[place]);
            }
            harmonics
        };
        let vector =
            |column: usize| self.in_order((0..n).map(|i| spectrum(i, column, self.harmonics)));
        let mut jacobian = DMatrix::zeros(self.size(), self.size() + 1);
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let [stiffness, damping] =
                [1 + j, 1 + n + j].map(|column| spectrum(i, column, 2 * self.harmonics));
            let size = self.block();
            let mut block = jacobian.view_mut((i * size, j * size), (size, size));
            self.add_coupling(&stiffness, &damping, omega, block.as_view_mut());
            if i == j {
                for row in 1..size {
                    block[(row, row)] -= (omega * row.div_ceil(2) as f64).powi(2);
                }
            }
        }
        if let Some(place) = self.frequency_place() {
            jacobian.set_column(place, &vector(2 * n + 2));
        }
        jacobian.set_column(self.size(), &vector(2 * n + 1));
        Some(Linearised { residual: vector(0), jacobian, scale })
    }

    /// Adds the derivatives of the harmonics of a force by the unknowns of a coordinate, from the
    /// harmonics of its derivatives by position and velocity.
    fn add_coupling(
        &self,
        stiffness: &Harmonics,
        damping: &Harmonics,
        omega: f64,
        mut block: DMatrixViewMut<f64>,
    ) {
        // Coefficients (cos or sin of k) of s(theta) times the wave (cos or sin of l), s having these
        // harmonics: [[cos by cos, cos by sin], [sin by cos, sin by sin]].
        let coupled = |s: &Harmonics, k: isize, l: isize| {
            let (near, far) = (s.cosine(k - l), s.cosine(k + l));
            let (apart, together) = (s.sine(k - l), s.sine(k + l));
            [
                [0.5 * (near + far), 0.5 * (together - apart)],
                [0.5 * (together + apart), 0.5 * (near - far)],
            ]
        };
        for l in 0..=self.harmonics {
            for k in 0..=self.harmonics {
                let of_stiffness = coupled(stiffness, k as isize, l as isize);
                let of_damping = coupled(damping, k as isize, l as isize);
                // The derivative of a cosine is minus a sine, and of a sine a cosine.
                let speed = omega * l as f64;
                // The mean is half the coefficient of harmonic 0, and has no sine.
                let part = if k == 0 { 0.5 } else { 1.0 };
                for row in 0..if k == 0 { 1 } else { 2 } {
                    let [by_cosine, by_sine] = of_stiffness[row];
                    let [damped_cosine, damped_sine] = of_damping[row];
                    let place = (2 * k + row).saturating_sub(1);
                    if l == 0 {
                        block[(place, 0)] += part * by_cosine;
                    } else {
                        block[(place, 2 * l - 1)] += part * (by_cosine - speed * damped_sine);
                        block[(place, 2 * l)] += part * (by_sine + speed * damped_cosine);
                    }
                }
            }
        }
    }

    /// Newton's method for the unknowns at a fixed parameter; `equations` gives the residual and
    /// its derivatives. Returns `None` if it does not converge.
    pub fn solve(
        &self,
        guess: &DVector<f64>,
        equations: impl Fn(&DVector<f64>) -> Option<Linearised>,
    ) -> Option<DVector<f64>> {
        const MOST: usize = 40;
        let vanishes = Cell::new(false);
        let square = |unknowns: &DVector<f64>| {
            let linear = equations(unknowns)?;
            vanishes.set(linear.residual.norm() <= 1e-14 * linear.scale);
            Some((linear.residual, linear.jacobian.remove_column(self.size())))
        };
        let judged = |unknowns: &DVector<f64>, step: &DVector<f64>| {
            if !unknowns.norm().is_finite() {
                return Progress::Lost;
            }
            let settled = match self.frequency_place() {
                None => step.norm() <= CONVERGED * unknowns.norm(),
                // The frequency has a unit of its own, so its step is compared with the frequency
                // alone.
                Some(place) => {
                    let [size, moved] = [unknowns, step].map(|vector| {
                        let means = vector.iter().step_by(self.block());
                        means.fold(self.extent(vector), |size, mean| size.hypot(*mean))
                    });
                    moved <= CONVERGED * size
                        && step[place].abs() <= CONVERGED * unknowns[place].abs()
                }
            };
            match settled || vanishes.get() {
                true => Progress::Settled,
                false => Progress::Going,
            }
        };
        newton(guess.clone(), MOST, square, judged)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, SMatrix, SVector};
    use num_complex::Complex;

    use super::*;
    use crate::numeric::continuation::{ContinuationStep, bordered, follow, tangent};
    use crate::numeric::ode::{IntegrationOptions, Point, integrate_first_order};
    use crate::numeric::periodic::{PeriodicOrbit, Shooting, by_differences};

    /// A force on two coordinates.
    type Force = fn(f64, &[[f64; 2]], &mut ForceSample);

    /// `x'' + D x' + K x = (cos theta, 0)`.
    const STIFFNESS: Matrix2<f64> = Matrix2::new(3.0, -1.0, -1.0, 2.0);
    const DAMPING: Matrix2<f64> = Matrix2::new(0.3, -0.1, -0.1, 0.2);

    fn chain(phase: f64, state: &[[f64; 2]], sample: &mut ForceSample) {
        for i in 0..2 {
            let term = |j: usize| STIFFNESS[(i, j)] * state[j][0] + DAMPING[(i, j)] * state[j][1];
            sample.value[i] = term(0) + term(1);
        }
        sample.value[0] -= phase.cos();
        sample.by_position.copy_from(&STIFFNESS);
        sample.by_velocity.copy_from(&DAMPING);
    }

    /// `x'' + x'/10 + x + x^3 + s = cos(theta)/2`, `y'' + 3/20 y' + 5y + y^3/2 - s = 0` with
    /// `s = (z + z^3)/5`, `z = x - y`.
    fn duffing(phase: f64, state: &[[f64; 2]], sample: &mut ForceSample) {
        let [[x, v], [y, w]] = [state[0], state[1]];
        let apart = x - y;
        let (spring, stiffness) = (0.2 * (apart + apart.powi(3)), 0.2 + 0.6 * apart * apart);
        sample.value[0] = 0.1 * v + x + x.powi(3) + spring - 0.5 * phase.cos();
        sample.value[1] = 0.15 * w + 5.0 * y + 0.5 * y.powi(3) - spring;
        sample.by_position.fill(-stiffness);
        sample.by_position[(0, 0)] = 1.0 + 3.0 * x * x + stiffness;
        sample.by_position[(1, 1)] = 5.0 + 1.5 * y * y + stiffness;
        sample.by_velocity.copy_from(&Matrix2::new(0.1, 0.0, 0.0, 0.15));
    }

    /// `x'' - (1 - x^2) x'/2 + x + 3/10 (x - y) = 0`, `y'' - (1 - y^2) y'/2 + 6/5 y = 3/10 (x - y)`.
    fn van_der_pol(_: f64, state: &[[f64; 2]], sample: &mut ForceSample) {
        let [[x, v], [y, w]] = [state[0], state[1]];
        sample.value[0] = -0.5 * (1.0 - x * x) * v + x + 0.3 * (x - y);
        sample.value[1] = -0.5 * (1.0 - y * y) * w + 1.2 * y - 0.3 * (x - y);
        sample.by_position.copy_from(&Matrix2::new(x * v + 1.3, -0.3, -0.3, y * w + 1.5));
        sample.by_velocity.fill_with_identity();
        sample.by_velocity[(0, 0)] = -0.5 * (1.0 - x * x);
        sample.by_velocity[(1, 1)] = -0.5 * (1.0 - y * y);
    }

    /// The unknowns of a motion near a guess.
    fn solved(
        balance: &HarmonicBalance,
        guess: &DVector<f64>,
        omega: f64,
        force: Force,
    ) -> DVector<f64> {
        let equations = |u: &DVector<f64>| {
            balance.linearised(
                &balance.motion(u),
                [balance.frequency(u, omega), 0.0],
                LocatedForces::default(),
                force,
            )
        };
        balance.solve(guess, equations).expect("a motion")
    }

    /// Positions, then velocities, at phase zero.
    fn start(balance: &HarmonicBalance, unknowns: &DVector<f64>, omega: f64) -> [f64; 4] {
        let [[x, v], [y, w]] = [0, 1].map(|i| balance.at(unknowns, i, omega, 0.0));
        [x, y, v, w]
    }

    /// The true motion near a start, by shooting; of unknown period where nothing drives it.
    fn orbit(force: Force, omega: f64, guess: [f64; 4], driven: bool) -> PeriodicOrbit<4, ()> {
        let rates = |t: f64, [x, y, v, w]: [f64; 4]| {
            let mut sample = ForceSample::zeros(2);
            force(omega * t, &[[x, v], [y, w]], &mut sample);
            [v, w, -sample.value[0], -sample.value[1]]
        };
        let in_time = |t: f64, y: &[f64; 4], out: &mut [f64; 4]| *out = rates(t, *y);
        let free = |y: [f64; 4]| rates(0.0, y);
        let sizes = [1.0; 4];
        let follow = |start: [f64; 4], period: f64| {
            let (begin, options) =
                (Point { t: 0.0, y: start }, IntegrationOptions::with_tolerance(1e-13));
            let path = integrate_first_order(in_time, begin, period, &[], &options).ok()?;
            Some((path.end().y, ()))
        };
        let shooting = Shooting {
            guess,
            period: TAU / omega,
            rates: if driven { None } else { Some(&free) },
            sizes,
            solve: |matrix, missed| matrix.svd(true, true).solve(&missed, 1e-9).ok(),
            most: 20,
            far: 0.5,
            known: &[],
        };
        let of_period = |start, period| by_differences(start, sizes, |start| follow(start, period));
        shooting.orbit(of_period, |_, moved| moved < 1e-10).expect("an orbit")
    }

    fn assert_near(found: [f64; 4], expected: [f64; 4], allowed: f64) {
        let apart = (SVector::from(found) - SVector::from(expected)).amax();
        assert!(apart < allowed, "{found:?} {expected:?}");
    }

    /// `x = Re (K - omega^2 + i omega D)^(-1) (1, 0) exp(i theta)`.
    #[test]
    fn a_linear_chain_moves_as_its_complex_amplitudes_do() {
        let balance = HarmonicBalance::new(2, 3, true, None);
        for omega in [0.7, 1.4, 3.0] {
            let dynamic = SMatrix::<_, 2, 2>::from_fn(|i, j| {
                let inertia = if i == j { omega * omega } else { 0.0 };
                Complex::new(STIFFNESS[(i, j)] - inertia, omega * DAMPING[(i, j)])
            });
            let drive = SVector::from([1.0, 0.0].map(Complex::from));
            let exact = dynamic.lu().solve(&drive).expect("off resonance");
            let found = solved(&balance, &DVector::zeros(balance.size()), omega, chain);
            for (i, amplitude) in exact.iter().enumerate() {
                let [cosine, sine] = balance.harmonic(&found, i, 1);
                assert!((cosine - amplitude.re).hypot(sine + amplitude.im) < 1e-12, "{omega}");
                for harmonic in [0, 2, 3] {
                    let [cosine, sine] = balance.harmonic(&found, i, harmonic);
                    assert!(cosine.hypot(sine) < 1e-12, "{omega}");
                }
            }
        }
    }

    #[test]
    fn coupled_oscillators_of_duffing_move_as_shooting_says() {
        let balance = HarmonicBalance::new(2, 24, true, None);
        for omega in [0.4, 0.9, 3.0] {
            let found = solved(&balance, &DVector::zeros(balance.size()), omega, duffing);
            let begin = start(&balance, &found, omega);
            assert_near(orbit(duffing, omega, begin.map(|y| 0.99 * y), true).start, begin, 1e-9);
            // Begun later it is the same motion, known by its places.
            let places = |i: usize| -> Vec<f64> {
                let phase = |sample: usize| TAU * sample as f64 / 100.0;
                (0..100)
                    .map(|sample| balance.at(&found, i, omega, phase(sample) + 1.0)[0])
                    .collect()
            };
            let turned = balance.coefficients_of(&[&places(0), &places(1)]);
            assert!((balance.later(&found, 1.0) - turned).amax() < 1e-12);
        }
    }

    /// The frequency does not depend on the coordinate whose first sine is zero.
    #[test]
    fn coupled_oscillators_of_van_der_pol_have_their_frequency() {
        for anchor in 0..2 {
            let balance = HarmonicBalance::new(2, 28, true, Some(anchor));
            let places: Vec<f64> =
                (0..100).map(|k| 2.0 * (TAU * f64::from(k) / 100.0).sin()).collect();
            let guess = balance.unknowns_of(&[&places, &places], 1.05);
            let found = solved(&balance, &guess, 0.0, van_der_pol);
            let omega = balance.frequency(&found, 0.0);
            assert_eq!(balance.harmonic(&found, anchor, 1)[1], 0.0);
            let begin = start(&balance, &found, omega);
            let truth = orbit(van_der_pol, 1.01 * omega, begin, false);
            assert!((truth.period * omega / TAU - 1.0).abs() < 1e-9, "{}", truth.period);
            assert!(begin[0].abs() > 1.0 && (begin[0] - begin[1]).abs() > 0.01, "{begin:?}");
        }
    }

    /// Pseudo-arclength in the plain norm, the frequency being the parameter: at the fold one of
    /// four Floquet multipliers leaves the unit circle.
    #[test]
    fn a_branch_of_two_coordinates_passes_its_fold() {
        let balance = HarmonicBalance::new(2, 15, true, None);
        let size = balance.size();
        let linearised = |at: &DVector<f64>| {
            let motion = balance.motion(&at.rows(0, size).into_owned());
            balance.linearised(&motion, [at[size], 1.0], LocatedForces::default(), duffing)
        };
        let step = |points: &[(DVector<f64>, DVector<f64>)], length: &mut f64| {
            let (here, along) = &points[points.len() - 1];
            let guess = here + along * *length;
            let equations = |at: &DVector<f64>| {
                let linear = linearised(at)?;
                let residual = linear.residual.push(along.dot(&(at - &guess)));
                Some((residual, bordered(&linear.jacobian, along)))
            };
            let judged = |_: &DVector<f64>, step: &DVector<f64>| match step.norm() < 1e-11 {
                true => Progress::Settled,
                false => Progress::Going,
            };
            let next = newton(guess.clone(), 8, equations, judged).and_then(|at| {
                let factors = bordered(&linearised(&at)?.jacobian, along).lu();
                Some((tangent(&factors)?.normalize(), at))
            });
            match next {
                None => ContinuationStep::TooLong,
                Some((along, at)) if along[size] < -0.1 => {
                    ContinuationStep::Ended(Some((at, along)), "folded")
                }
                Some(_) if points.len() > 300 => ContinuationStep::Ended(None, "straight"),
                Some((along, at)) => ContinuationStep::Taken((at, along), 1.4),
            }
        };
        let first = solved(&balance, &DVector::zeros(size), 0.9, duffing).push(0.9);
        let mut upward = DVector::zeros(size + 1);
        upward[size] = 1.0;
        let (points, end) = follow((first, upward), 0.01, 0.05, step);
        assert_eq!(end, "folded");
        for (index, attracts) in [(0, true), (points.len() - 1, false)] {
            let at = &points[index].0;
            let (unknowns, omega) = (at.rows(0, size).into_owned(), at[size]);
            let begin = start(&balance, &unknowns, omega);
            let truth = orbit(duffing, omega, begin.map(|y| 0.999 * y), true);
            assert_near(truth.start, begin, 1e-9);
            assert_eq!((truth.attracts(), truth.multipliers().len()), (attracts, 4), "{omega}");
        }
    }

    /// Forces are the same whether they are sampled or come as integrals at the phases of the
    /// samples.
    #[test]
    fn located_forces_count_as_sampled_ones_do() {
        let balance = HarmonicBalance::new(2, 3, true, Some(1));
        let unknowns =
            DVector::from_fn(balance.size(), |index, _| (1.3 * index as f64 + 1.0).sin());
        let (motion, omega) = (balance.motion(&unknowns), 1.7);
        let force = |phase: f64, state: &[[f64; 2]], sample: &mut ForceSample| {
            van_der_pol(phase, state, sample);
            sample.by_parameter.copy_from_slice(&[state[0][0], state[1][1] * phase.cos()]);
        };
        let step = TAU / balance.samples() as f64;
        let mut all = LocatedForces::default();
        for (index, ([x, v, _], [y, w, _])) in motion[0].iter().zip(&motion[1]).enumerate() {
            let (phase, velocities) = (step * index as f64, [omega * v, omega * w]);
            let mut integral = ForceSample::zeros(2);
            force(phase, &[[*x, velocities[0]], [*y, velocities[1]]], &mut integral);
            integral.value *= step;
            integral.by_position *= step;
            integral.by_velocity *= step;
            integral.by_parameter *= step;
            all.push(phase, &velocities, &integral);
        }
        let sampled = balance
            .linearised(&motion, [omega, 0.6], LocatedForces::default(), force)
            .expect("values");
        let added = balance.linearised(&motion, [omega, 0.6], all, |_, _, _| ()).expect("values");
        assert!((sampled.residual - added.residual).amax() < 1e-12);
        assert!((sampled.jacobian - added.jacobian).amax() < 1e-12);
    }
}

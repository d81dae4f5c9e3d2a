//! Laws of a driven oscillator from its frequency response: amplitude, and perhaps phase, against the frequency of the drive.
//!
//! ```text
//! x'' = a(x, v, Omega t; p),   Phi(y; p) = y after a period T = 2 pi/Omega from y = (x_0, v_0)        M = dPhi/dy
//! y* = Phi(y*; p),   dy*/dp = (I - M)^(-1) dPhi/dp                                  stable if |mu| <= 1 for both multipliers of M
//! x = A cos(Omega t - phi) + ...:   the first harmonic is what is compared
//! ```
//!
//! At a frequency with several motions the stable one nearest to the measured amplitude counts. The balance of one harmonic says where to
//! look for them: an amplitude A needs a drive of the size `|G(A)|`, which has to be that of the equation. That balance
//! also gives the start of the search, for each measured amplitude has one `G`, however many motions its frequency has.
//!
//! (A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, chapter 4.)

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use thiserror::Error;

use crate::expr::CompiledFunction;
use crate::fit::answer::Estimate;
use crate::fit::laws::{Law, LawError};
use crate::fit::least_squares::{Covariance, Linearised, minimise};
use crate::fit::motion::MotionSolver;
use crate::symbol::Symbol;

/// One row of a frequency response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponseRow {
    /// The angular frequency of the drive.
    pub frequency: f64,
    /// The amplitude of the first harmonic.
    pub amplitude: f64,
    /// Its phase behind the time of the equation, in radians: `amplitude cos(frequency t - phase)`.
    pub phase: Option<f64>,
}

/// A frequency response at one level of the drive or at several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrequencyResponse {
    /// The rows, in any order.
    pub rows: Vec<ResponseRow>,
    /// The letters of the equation that are known, with their value in each row, such as the size of a
    /// drive at several levels.
    pub known: Vec<(Symbol, Vec<f64>)>,
}

/// A law fitted to a frequency response.
#[derive(Clone, Debug)]
pub struct ResponseFit {
    /// The law.
    pub law: Law,
    /// The unknown letters with their standard errors; infinite where the response leaves them open.
    pub estimates: Vec<Estimate>,
    /// Amplitude and phase of the law at each row.
    pub fitted: Vec<[f64; 2]>,
    /// The scatter of the amplitudes about the law.
    pub noise: f64,
    /// Whether the search converged.
    pub converged: bool,
}

/// The reason why a frequency response has no law.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ResponseError {
    /// The equation cannot be fitted.
    #[error(transparent)]
    Law(#[from] LawError),
    /// The equation has no drive of one frequency that is a letter.
    #[error("`{0}` has no drive such as `cos(Omega*t)`, in which a letter is the frequency")]
    NoDrive(String),
    /// There are too few rows.
    #[error(
        "the response has {found} rows; at least {needed} are needed for the letters of the equation"
    )]
    TooFew {
        /// The number of rows.
        found: usize,
        /// The number needed.
        needed: usize,
    },
    /// A row has a number that is not positive.
    #[error("row {0}, counted from 1: frequency and amplitude must be positive numbers")]
    NotPositive(usize),
    /// No values of the letters give such a response.
    #[error("no motion of `{0}` was found near the response")]
    NoFit(String),
}

impl ResponseError {
    /// A way forward.
    pub fn help(&self) -> &'static str {
        match self {
            Self::Law(error) => error.help(),
            Self::NoDrive(_) => "write the drive, such as `x'' + c*x' + k*x = F*cos(Omega*t)`",
            Self::TooFew { .. } => "measure at further frequencies",
            Self::NotPositive(_) => "give frequencies and amplitudes as positive numbers",
            Self::NoFit(_) => "give a first value for each letter",
        }
    }
}

/// Fits the unknown letters of a driven equation to its frequency response; `start` gives first values of all letters in the order of the
/// law, without it they are found from the balance of one harmonic.
///
/// # Errors
/// [`ResponseError`].
///
/// ```
/// use lindstedt_fit::fit::laws::Law;
/// use lindstedt_fit::fit::response::{FrequencyResponse, ResponseRow, fit_response};
///
/// // A linear oscillator: A = F/sqrt((k - Omega^2)^2 + (c Omega)^2) with k = 1, c = 0.2, F = 0.5, and a ripple in place of noise.
/// let row = |index: u32| {
///     let frequency = 0.5 + 0.05 * f64::from(index);
///     let size = 0.5 / (1.0 - frequency * frequency).hypot(0.2 * frequency);
///     let ripple = 1e-3 * (7.0 * f64::from(index)).sin();
///     ResponseRow { frequency, amplitude: size + ripple, phase: None }
/// };
/// let response = FrequencyResponse { rows: (0..24).map(row).collect(), known: vec![] };
/// let law = Law::parse("x'' + c*x' + k*x = F*cos(Omega*t)")?;
/// let fit = fit_response(&law, &response, None)?;
/// let k = fit.estimates.iter().find(|own| own.name == "k").ok_or("a letter")?;
/// assert!((k.value - 1.0).abs() < 3.0 * k.error && k.error < 1e-2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn fit_response(
    law: &Law,
    response: &FrequencyResponse,
    start: Option<&[f64]>,
) -> Result<ResponseFit, ResponseError> {
    let problem = ResponseProblem::new(law, response)?;
    let no_fit = || ResponseError::NoFit(law.equation.clone());
    let starts = match start {
        Some(start) => vec![problem.unknown.iter().map(|place| start[*place]).collect()],
        None => problem.starts(),
    };
    const ITERATIONS: u64 = 60;
    let mut fits = starts.iter().filter_map(|start| {
        minimise(start, ITERATIONS, |values| problem.linearised(values, 1.0).map(|found| found.0))
    });
    let first = fits.next().ok_or_else(no_fit)?;
    // Phases count by their own scatter.
    let [of_amplitudes, of_phases] = problem.scatter(first.residuals.as_slice(), 1.0);
    let weight = match of_phases > 0.0 && of_amplitudes > 0.0 {
        true => of_amplitudes / of_phases,
        false => 1.0,
    };
    let found = minimise(&first.parameters, ITERATIONS, |values| {
        problem.linearised(values, weight).map(|found| found.0)
    });
    let found = found.ok_or_else(no_fit)?;
    let (_, fitted) = problem.linearised(&found.parameters, weight).ok_or_else(no_fit)?;
    let freedom = (found.residuals.len() - problem.unknown.len()) as f64;
    let variance = found.square() / freedom;
    let covariance = Covariance::new(&found.jacobian);
    let is_open = |index: usize| covariance.flat.iter().any(|own| own[index] != 0.0);
    let estimates = problem.unknown.iter().zip(&found.parameters).enumerate();
    let estimates = estimates.map(|(index, (place, value))| Estimate {
        name: law.parameters[*place].to_string(),
        value: *value,
        error: match is_open(index) {
            true => f64::INFINITY,
            false => (covariance.matrix[(index, index)] * variance).sqrt(),
        },
    });
    let [noise, _] = problem.scatter(found.residuals.as_slice(), weight);
    const NEAR: f64 = 0.01;
    Ok(ResponseFit {
        law: law.clone(),
        estimates: estimates.collect(),
        fitted,
        noise,
        converged: found.distance() < NEAR,
    })
}

/// A steady motion.
struct SteadyMotion {
    /// The coefficients of `cos(Omega t)` and `sin(Omega t)`.
    harmonic: [f64; 2],
    /// Their derivatives by each parameter of the law.
    slopes: Vec<[f64; 2]>,
    is_stable: bool,
}

/// The rows with the law that they are compared with.
struct ResponseProblem<'a> {
    solver: MotionSolver,
    /// The acceleration as a function of x, v, t and the parameters.
    acceleration: CompiledFunction,
    /// Each row with its parameters; unknown ones are set later.
    rows: Vec<(&'a ResponseRow, Vec<f64>)>,
    /// The places of the unknown letters among the parameters.
    unknown: Vec<usize>,
}

/// The numbers of samples of a period, of a motion and in the balance of one harmonic.
const SAMPLES: u32 = 64;
const SAMPLES_OF_BALANCE: u32 = 24;

impl<'a> ResponseProblem<'a> {
    fn new(law: &Law, response: &'a FrequencyResponse) -> Result<Self, ResponseError> {
        let frequency =
            law.drive_frequency().ok_or_else(|| ResponseError::NoDrive(law.equation.clone()))?;
        let known = |name: Symbol| response.known.iter().find(|(own, _)| *own == name);
        let is_known = |name: Symbol| name == frequency || known(name).is_some();
        let unknown: Vec<usize> =
            (0..law.parameters.len()).filter(|place| !is_known(law.parameters[*place])).collect();
        let with_parameters = |(place, row): (usize, &'a ResponseRow)| {
            let value = |name: &Symbol| match *name == frequency {
                true => row.frequency,
                false => known(*name).and_then(|(_, own)| own.get(place).copied()).unwrap_or(0.0),
            };
            (row, law.parameters.iter().map(value).collect())
        };
        let rows: Vec<(&ResponseRow, Vec<f64>)> =
            response.rows.iter().enumerate().map(with_parameters).collect();
        let is_positive = |value: f64| value.is_finite() && value > 0.0;
        let wrong = |(row, _): &(&ResponseRow, Vec<f64>)| {
            !is_positive(row.frequency) || !is_positive(row.amplitude)
        };
        if let Some(place) = rows.iter().position(wrong) {
            return Err(ResponseError::NotPositive(place + 1));
        }
        let (found, needed) = (rows.len(), unknown.len() + 2);
        if found < needed {
            return Err(ResponseError::TooFew { found, needed });
        }
        let variables = [law.coordinate, law.coordinate.derivative(), Symbol::new("t")];
        let arguments = [&variables, law.parameters.as_slice()].concat();
        let acceleration = CompiledFunction::new(&law.acceleration, &arguments)
            .map_err(|_| LawError::Jump(law.equation.clone()))?;
        Ok(Self { solver: MotionSolver::new(law)?, acceleration, rows, unknown })
    }

    /// The parameters of a row with these values of the unknown letters.
    fn parameters(&self, row: usize, values: &[f64]) -> Vec<f64> {
        let mut parameters = self.rows[row].1.clone();
        self.unknown.iter().zip(values).for_each(|(place, value)| parameters[*place] = *value);
        parameters
    }

    /// The first harmonic of a function of the angle.
    fn first_harmonic(mut value: impl FnMut(f64) -> f64) -> [f64; 2] {
        let (mut cosine, mut sine) = (0.0, 0.0);
        let share = 2.0 / f64::from(SAMPLES_OF_BALANCE);
        for index in 0..SAMPLES_OF_BALANCE {
            // Beside the corners of friction.
            let angle =
                std::f64::consts::TAU * (f64::from(index) + 0.5) / f64::from(SAMPLES_OF_BALANCE);
            let own = share * value(angle);
            cosine += own * angle.cos();
            sine += own * angle.sin();
        }
        [cosine, sine]
    }

    /// The drive that the balance of one harmonic needs for this amplitude, in the phase of the motion.
    fn needed_drive(&self, parameters: &[f64], rate: f64, amplitude: f64) -> [f64; 2] {
        let half = std::f64::consts::PI / rate;
        let mut arguments = [&[0.0; 3], parameters].concat();
        let mut at = |x: f64, v: f64, time: f64| {
            arguments[..3].copy_from_slice(&[x, v, time]);
            self.acceleration.call(&arguments)
        };
        // The mean of two instants half a period apart has the drive no more.
        let [cosine, sine] = Self::first_harmonic(|angle| {
            let (x, v) = (amplitude * angle.cos(), -amplitude * rate * angle.sin());
            -0.5 * (at(x, v, 0.0) + at(x, v, half))
        });
        [cosine - rate * rate * amplitude, sine]
    }

    /// The first harmonic of the drive of the equation, from its change over half a period.
    fn drive(&self, parameters: &[f64], rate: f64, amplitude: f64) -> [f64; 2] {
        let half = std::f64::consts::PI / rate;
        let mut arguments = [&[amplitude, 0.0, 0.0], parameters].concat();
        let mut at = |time: f64| {
            arguments[2] = time;
            self.acceleration.call(&arguments)
        };
        Self::first_harmonic(|angle| 0.5 * (at(angle / rate) - at(angle / rate + half)))
    }

    /// The phase of a motion of this amplitude by the balance of one harmonic.
    fn phase(&self, parameters: &[f64], rate: f64, amplitude: f64) -> f64 {
        let needed = self.needed_drive(parameters, rate, amplitude);
        let drive = self.drive(parameters, rate, amplitude);
        drive[1].atan2(drive[0]) - needed[1].atan2(needed[0])
    }

    /// Amplitudes of motions by the balance of one harmonic.
    fn guesses(&self, parameters: &[f64], row: &ResponseRow) -> Vec<f64> {
        const STEPS: i32 = 24;
        const DECADES: f64 = 2.0;
        let drive = self.drive(parameters, row.frequency, row.amplitude);
        let excess = |amplitude: f64| {
            let needed = self.needed_drive(parameters, row.frequency, amplitude);
            needed[0].hypot(needed[1]) - drive[0].hypot(drive[1])
        };
        let mut guesses = vec![];
        let mut before: Option<(f64, f64)> = None;
        for step in -STEPS..=STEPS {
            let amplitude =
                row.amplitude * 10.0_f64.powf(DECADES * f64::from(step) / f64::from(STEPS));
            let own = excess(amplitude);
            if let Some((last, value)) = before
                && value * own < 0.0
            {
                guesses.push(last + (amplitude - last) * value / (value - own));
            }
            before = Some((amplitude, own));
        }
        guesses
    }

    /// The steady motion from a start by Newton's method on the map of a period.
    fn steady(&self, parameters: &[f64], rate: f64, start: [f64; 2]) -> Option<SteadyMotion> {
        const ROUNDS: usize = 12;
        const CLOSED: f64 = 1e-8;
        /// The amount by which a multiplier of a motion without damping is off by rounding.
        const ROUNDING: f64 = 1e-6;
        let period = std::f64::consts::TAU / rate;
        let times: Vec<f64> =
            (0..=SAMPLES).map(|index| period * f64::from(index) / f64::from(SAMPLES)).collect();
        let last = SAMPLES as usize;
        let width = parameters.len();
        let mut state = Vector2::new(start[0], start[1]);
        for _ in 0..ROUNDS {
            let [x, v] =
                self.solver.sample_phase(parameters, state.into(), &times, 0.5 * period)?;
            let map = |column: usize| Vector2::new(x[column][last], v[column][last]);
            let monodromy = Matrix2::from_columns(&[map(width + 1), map(width + 2)]);
            let inverse = (Matrix2::identity() - monodromy).try_inverse()?;
            let gap = map(0) - state;
            let size = x[0].iter().fold(0.0_f64, |size, own| size.max(own.abs()));
            if gap[0].hypot(gap[1] / rate) > CLOSED * size {
                state += inverse * gap;
                continue;
            }
            let harmonic = |column: &[f64]| {
                let (mut cosine, mut sine) = (0.0, 0.0);
                for (index, own) in column[..last].iter().enumerate() {
                    let angle = std::f64::consts::TAU * index as f64 / f64::from(SAMPLES);
                    cosine += 2.0 / f64::from(SAMPLES) * own * angle.cos();
                    sine += 2.0 / f64::from(SAMPLES) * own * angle.sin();
                }
                [cosine, sine]
            };
            let [by_x, by_v] = [harmonic(&x[width + 1]), harmonic(&x[width + 2])];
            let slopes = (0..width).map(|place| {
                let moved = inverse * map(place + 1);
                let own = harmonic(&x[place + 1]);
                [0, 1].map(|part| own[part] + by_x[part] * moved[0] + by_v[part] * moved[1])
            });
            let (trace, determinant) = (monodromy.trace(), monodromy.determinant());
            // Both multipliers are within the unit circle.
            let is_stable =
                determinant <= 1.0 + ROUNDING && trace.abs() <= 1.0 + determinant + ROUNDING;
            return Some(SteadyMotion {
                harmonic: harmonic(&x[0]),
                slopes: slopes.collect(),
                is_stable,
            });
        }
        None
    }

    /// The stable motion of a row nearest to the measured amplitude.
    fn nearest(&self, row: usize, values: &[f64]) -> Option<SteadyMotion> {
        /// The share of the amplitude within which a second stable motion is not looked for.
        const SAME: f64 = 0.1;
        let own = self.rows[row].0;
        let parameters = self.parameters(row, values);
        let rate = own.frequency;
        let from = |amplitude: f64| {
            let phase = self.phase(&parameters, rate, amplitude);
            let start = [amplitude * phase.cos(), amplitude * rate * phase.sin()];
            self.steady(&parameters, rate, start).filter(|motion| motion.is_stable)
        };
        let distance = |motion: &SteadyMotion| {
            (motion.harmonic[0].hypot(motion.harmonic[1]) - own.amplitude).abs()
        };
        let first = from(own.amplitude);
        if first.as_ref().is_some_and(|motion| distance(motion) < SAME * own.amplitude) {
            return first;
        }
        let motions = self.guesses(&parameters, own).into_iter().filter_map(from);
        let motions = first.into_iter().chain(motions);
        motions.min_by(|one, other| distance(one).total_cmp(&distance(other)))
    }

    /// The residuals of amplitudes, each followed by that of its phase times the amplitude and this weight, with their derivatives; then
    /// amplitude and phase of each row. Returns `None` if a row has no stable motion.
    fn linearised(&self, values: &[f64], weight: f64) -> Option<(Linearised, Vec<[f64; 2]>)> {
        let (mut residuals, mut slopes, mut fitted) = (vec![], vec![], vec![]);
        for (place, (row, _)) in self.rows.iter().enumerate() {
            let motion = self.nearest(place, values)?;
            let [cosine, sine] = motion.harmonic;
            let (size, phase) = (cosine.hypot(sine), sine.atan2(cosine));
            residuals.push(size - row.amplitude);
            let own = self.unknown.iter().map(|place| motion.slopes[*place]);
            slopes.extend(own.clone().map(|[by_c, by_s]| (cosine * by_c + sine * by_s) / size));
            if let Some(measured) = row.phase {
                let (off, on) = (phase - measured).sin_cos();
                residuals.push(weight * row.amplitude * off.atan2(on));
                let factor = weight * row.amplitude / (size * size);
                slopes.extend(own.map(|[by_c, by_s]| factor * (cosine * by_s - sine * by_c)));
            }
            fitted.push([size, phase]);
        }
        let jacobian = DMatrix::from_row_slice(residuals.len(), values.len(), &slopes);
        Some(((DVector::from_vec(residuals), jacobian), fitted))
    }

    /// The scatter of amplitudes, and of phases times the amplitude, zero where there are none.
    fn scatter(&self, residuals: &[f64], weight: f64) -> [f64; 2] {
        let mut own = residuals.iter();
        let (mut squares, mut counts) = ([0.0; 2], [0.0; 2]);
        for (row, _) in &self.rows {
            let both = [own.next(), row.phase.and_then(|_| own.next())];
            for (kind, residual) in both.into_iter().enumerate() {
                let Some(residual) = residual else { continue };
                squares[kind] += (residual / if kind == 1 { weight } else { 1.0 }).powi(2);
                counts[kind] += 1.0;
            }
        }
        let total: f64 = counts.iter().sum();
        // Each kind has its share of the degrees of freedom.
        let share = 1.0 - self.unknown.len() as f64 / total;
        [0, 1].map(|kind| (squares[kind] / (share * counts[kind]).max(f64::MIN_POSITIVE)).sqrt())
    }

    /// Starts from the balance of one harmonic, the best first: the ratio of the drive that a measured amplitude needs to the one that
    /// there is must be one.
    fn starts(&self) -> Vec<Vec<f64>> {
        /// The shares of the largest force of inertia that a term may have.
        const SHARES: [f64; 2] = [1.0, 0.05];
        const ITERATIONS: u64 = 30;
        const KEPT: usize = 3;
        let residuals = |values: &[f64]| -> Option<DVector<f64>> {
            let mut residuals = vec![];
            for (place, (row, _)) in self.rows.iter().enumerate() {
                let parameters = self.parameters(place, values);
                let needed = self.needed_drive(&parameters, row.frequency, row.amplitude);
                let drive = self.drive(&parameters, row.frequency, row.amplitude);
                residuals.push((needed[0].hypot(needed[1]) / drive[0].hypot(drive[1])).ln());
                if let Some(phase) = row.phase {
                    let own = drive[1].atan2(drive[0]) - needed[1].atan2(needed[0]);
                    let (off, on) = (own - phase).sin_cos();
                    residuals.push(off.atan2(on));
                }
            }
            let is_finite = residuals.iter().all(|own| own.is_finite());
            is_finite.then(|| DVector::from_vec(residuals))
        };
        let units = self.units();
        let linearised = |values: &[f64]| -> Option<Linearised> {
            const STEP: f64 = 1e-6;
            let at = residuals(values)?;
            let mut jacobian = DMatrix::zeros(at.len(), values.len());
            for (index, unit) in units.iter().enumerate() {
                let mut moved = values.to_vec();
                let step = STEP * values[index].abs().max(1e-3 * unit);
                moved[index] += step;
                jacobian.set_column(index, &((residuals(&moved)? - &at) / step));
            }
            Some((at, jacobian))
        };
        let count = SHARES.len().pow(units.len().min(5) as u32);
        let mut found: Vec<(f64, Vec<f64>)> = (0..count)
            .filter_map(|number| {
                let mut rest = number;
                let start = units.iter().map(|unit| {
                    let share = SHARES[rest % SHARES.len()];
                    rest /= SHARES.len();
                    share * unit
                });
                let minimum = minimise(&start.collect::<Vec<_>>(), ITERATIONS, linearised)?;
                Some((minimum.square(), minimum.parameters))
            })
            .collect();
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        found.dedup_by(|one, other| {
            let mut pairs = one.1.iter().zip(&other.1);
            pairs.all(|(one, other)| (one - other).abs() <= 0.01 * other.abs())
        });
        found.into_iter().take(KEPT).map(|(_, start)| start).collect()
    }

    /// The value of each unknown letter at which its term is as large as the largest force of inertia.
    fn units(&self) -> Vec<f64> {
        let largest = self.rows.iter().max_by(|one, other| {
            let force = |row: &ResponseRow| row.frequency * row.frequency * row.amplitude;
            force(one.0).total_cmp(&force(other.0))
        });
        let Some((row, known)) = largest else { return vec![1.0; self.unknown.len()] };
        let inertia = row.frequency.powi(2) * row.amplitude;
        let effect = |place: usize| {
            let mut arguments = [&[0.0; 3], known.as_slice()].concat();
            let mut most = 0.0_f64;
            for index in 0..SAMPLES {
                let angle = std::f64::consts::TAU * (f64::from(index) + 0.5) / f64::from(SAMPLES);
                let (sine, cosine) = angle.sin_cos();
                let speed = -row.amplitude * row.frequency * sine;
                arguments[..3].copy_from_slice(&[
                    row.amplitude * cosine,
                    speed,
                    angle / row.frequency,
                ]);
                let mut at = |value: f64| {
                    self.unknown.iter().for_each(|own| arguments[3 + own] = 1.0);
                    arguments[3 + place] = value;
                    self.acceleration.call(&arguments)
                };
                most = most.max((at(1.5) - at(0.5)).abs());
            }
            most
        };
        let unit = |place: &usize| {
            let unit = inertia / effect(*place);
            if unit.is_finite() && unit > 0.0 { unit } else { 1.0 }
        };
        self.unknown.iter().map(unit).collect()
    }
}

//! Laws fitted to turning points by the map of a half swing: the start of the fit to the samples.
//!
//! ```text
//! V(x_(n+1)) = V(x_n) - W,   t_(n+1) = t_n + T/2             V: potential of the spring, W: work of the loss in the half swing
//! T/2 = int dx/v,  W = int loss(v) dx,   v^2 = 2 (E - V(x)),   E linear in x from V(x_n) to V(x_(n+1))
//! ```
//!
//! For dry friction this is `A + A'` in closed form, for the pendulum T is the complete elliptic integral, for viscous damping W the
//! elliptic action. The integrals are computed in `x = m + r sin(phi)`, where they are smooth, by a Gauss
//! rule. The map is exact for dry friction, and to second order in any other loss.

use std::sync::LazyLock;

use nalgebra::{DMatrix, DVector};
use spec_math::cephes64::gamma;

use crate::fit::backbone::{BackbonePoint, backbone};
use crate::fit::laws::{Law, Loss, Spring};
use crate::fit::least_squares::{Covariance, Linearised, minimise};
use crate::fit::polynomial::regression;
use crate::fit::turning_points::Swings;
use crate::numeric::ode::quadrature::nodes_and_weights;
use crate::parallel::par_map;

/// A law fitted to turning points.
#[derive(Clone, Debug)]
pub struct MapFit {
    /// The parameters of the law.
    pub parameters: Vec<f64>,
    /// For each record the initial turning point, as its coordinate without the offset and its time, then the offset at
    /// the middle of the record and the drift per unit of time.
    pub starts: Vec<[f64; 4]>,
    /// The sum of the squares of the residuals over their errors.
    pub chi_square: f64,
    /// The standard error of the second parameter.
    second_error: f64,
}

/// The numbers of a law of the list in the roles of its equation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Numbers {
    spring: Spring,
    /// w^2 or k, then beta, b or n.
    stiffness: [f64; 2],
    /// The coefficients of v, sgn v, |v| v and |v|^p sgn v, and p.
    loss: [f64; 5],
}

impl Numbers {
    pub(crate) fn new(spring: Spring, loss: Loss, parameters: &[f64]) -> Self {
        let has_frequency = spring != Spring::Power;
        let first = parameters[0];
        let square = if has_frequency { first * first } else { first };
        let (second, rest) = match spring {
            Spring::Linear | Spring::Pendulum => (0.0, &parameters[1..]),
            Spring::Duffing | Spring::Quadratic | Spring::Power => {
                (parameters[1], &parameters[2..])
            }
        };
        let [viscous, dry] = if has_frequency { [2.0 * first, square] } else { [1.0, 1.0] };
        let loss = match loss {
            Loss::None => [0.0; 5],
            Loss::Viscous => [viscous * rest[0], 0.0, 0.0, 0.0, 1.0],
            Loss::Coulomb => [0.0, dry * rest[0], 0.0, 0.0, 1.0],
            Loss::Quadratic => [0.0, 0.0, rest[0], 0.0, 1.0],
            Loss::Power => [0.0, 0.0, 0.0, rest[0], rest[1]],
            Loss::ViscousAndCoulomb => [viscous * rest[0], dry * rest[1], 0.0, 0.0, 1.0],
        };
        Self { spring, stiffness: [square, second], loss }
    }

    fn potential(&self, x: f64) -> f64 {
        let [k, second] = self.stiffness;
        let square = x * x;
        match self.spring {
            Spring::Linear => 0.5 * k * square,
            Spring::Duffing => 0.5 * k * square + 0.25 * second * square * square,
            Spring::Quadratic => 0.5 * k * square + second * square * x / 3.0,
            Spring::Pendulum => 2.0 * k * (0.5 * x).sin().powi(2),
            Spring::Power => k * x.abs().powf(second + 1.0) / (second + 1.0),
        }
    }

    /// The turning point on the side of this sign with this energy.
    fn turning_point(&self, energy: f64, sign: f64) -> Option<f64> {
        let [k, second] = self.stiffness;
        let size = match self.spring {
            Spring::Linear => (2.0 * energy / k).sqrt(),
            Spring::Duffing => {
                // The smaller root of beta z^2/4 + k z/2 = E in z = x^2, without cancellation.
                let root = (0.25 * k * k + second * energy).sqrt();
                (2.0 * energy / (0.5 * k + root)).sqrt()
            }
            Spring::Pendulum => 2.0 * (0.5 * energy / k).sqrt().asin(),
            Spring::Power => ((second + 1.0) * energy / k).powf(1.0 / (second + 1.0)),
            Spring::Quadratic => {
                const ITERATIONS: usize = 30;
                let mut x = sign * (2.0 * energy / k).sqrt();
                for _ in 0..ITERATIONS {
                    let force = k * x + second * x * x;
                    let step = (self.potential(x) - energy) / force;
                    x -= step;
                    if step.abs() <= 1e-13 * x.abs() {
                        break;
                    }
                }
                if x * sign <= 0.0 || (k + 2.0 * second * x) * k <= 0.0 {
                    return None;
                }
                x.abs()
            }
        };
        (size.is_finite() && size > 0.0).then_some(sign * size)
    }

    fn loss(&self, speed: f64) -> f64 {
        let [viscous, dry, quadratic, power, exponent] = self.loss;
        let last = if power == 0.0 { 0.0 } else { power * speed.powf(exponent) };
        viscous * speed + dry + quadratic * speed * speed + last
    }

    /// The duration of a half swing between these turning points, given as coordinate and energy, and the work of the loss in
    /// it. In between the energy is linear in the coordinate, as it is with dry friction.
    fn half_swing(&self, [low, high]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
        let (middle, radius) = (0.5 * (low[0] + high[0]), 0.5 * (high[0] - low[0]));
        let (mut time, mut work) = (0.0, 0.0);
        for [sine, cosine, weight] in NODES.iter() {
            let energy = 0.5 * (low[1] + high[1] + sine * (high[1] - low[1]));
            let speed = (2.0 * (energy - self.potential(middle + radius * sine))).max(0.0).sqrt();
            time += weight * radius * cosine / speed;
            work += weight * self.loss(speed) * radius * cosine;
        }
        let both = [time, work];
        both.iter().all(|value| value.is_finite()).then_some(both)
    }

    /// The turning point after this one, the time between both and the work in it; `None` if the motion ends. The guess is the work of the
    /// half swing before.
    fn next(&self, x: f64, guess: f64) -> Option<[f64; 3]> {
        const ROUNDS: usize = 15;
        const CHANGE: f64 = 1e-11;
        let energy = self.potential(x);
        let round = |work: f64| -> Option<[f64; 2]> {
            let other = self.turning_point(energy - work, -x.signum())?;
            let [here, there] = [[x, energy], [other, energy - work]];
            self.half_swing(if x > 0.0 { [there, here] } else { [here, there] })
        };
        let (mut before, mut work, mut time) = (guess, 0.0, 0.0);
        for _ in 0..ROUNDS {
            [time, work] = round(before)?;
            if (work - before).abs() <= CHANGE * energy {
                break;
            }
            // By Aitken's formula: the error falls by the same factor in each round.
            let [_, next] = round(work)?;
            let bend = next - 2.0 * work + before;
            let step = (work - before).powi(2) / bend;
            before = if step.abs() <= (work - before).abs() { before - step } else { next };
        }
        Some([self.turning_point(energy - work, -x.signum())?, time, work])
    }
}

/// Sine and cosine of the nodes between -pi/2 and pi/2, with their weights.
static NODES: LazyLock<Vec<[f64; 3]>> = LazyLock::new(|| {
    let quarter = std::f64::consts::FRAC_PI_2;
    nodes_and_weights(-quarter, quarter)
        .map(|(angle, weight)| [angle.sin(), angle.cos(), weight])
        .collect()
});

impl Law {
    /// The angular frequency and the damping ratio against the amplitude, half the distance of turning points, with these values of
    /// the parameters. Returns `None` for an equation of one's own, and where the law has no such motion.
    pub fn frequency_and_damping(&self, parameters: &[f64], amplitude: f64) -> Option<[f64; 2]> {
        let (spring, loss) = self.parts?;
        let parameters = parameters.get(..self.parameters.len())?;
        Numbers::new(spring, loss, parameters).frequency_and_damping(amplitude)
    }
}

impl Numbers {
    /// The angular frequency and the damping ratio of a motion whose turning points are twice the amplitude apart.
    ///
    /// `zeta = W/(pi A dE/dA)`, with the work W of the loss in a half swing.
    pub(crate) fn frequency_and_damping(&self, amplitude: f64) -> Option<[f64; 2]> {
        const STEP: f64 = 1e-4;
        let energy_at = |amplitude: f64| self.energy(amplitude);
        let [time, work] = self.symmetric_half_swing(amplitude)?;
        let [above, below] = [1.0 + STEP, 1.0 - STEP].map(|share| energy_at(share * amplitude));
        let slope = (above? - below?) / (2.0 * STEP * amplitude);
        let pi = std::f64::consts::PI;
        Some([pi / time, work / (pi * amplitude * slope)])
    }

    /// The duration of a half swing of this amplitude and the work of the loss in it.
    fn symmetric_half_swing(&self, amplitude: f64) -> Option<[f64; 2]> {
        let energy = self.energy(amplitude)?;
        let turning = |sign| Some([self.turning_point(energy, sign)?, energy]);
        self.half_swing([turning(-1.0)?, turning(1.0)?])
    }

    /// The energy of a motion of this amplitude.
    fn energy(&self, amplitude: f64) -> Option<f64> {
        const ROUNDS: usize = 20;
        let mut energy = self.potential(amplitude);
        if self.spring != Spring::Quadratic {
            return Some(energy);
        }
        // Both turning points grow about as the square root of the energy.
        for _ in 0..ROUNDS {
            let own =
                0.5 * (self.turning_point(energy, 1.0)? - self.turning_point(energy, -1.0)?);
            energy *= (amplitude / own).powi(2);
        }
        Some(energy)
    }
}

/// Fits laws of the list to the turning points of all records: for each the best fit, then others that the turning points do not tell from
/// it. There is none for an equation of one's own and where no motion of the law is near.
///
/// The search for the numbers of a spring is made once, with the loss of two parameters, which is near any other one.
pub fn fit_maps(laws: &[Law], records: &[&Swings]) -> Vec<Vec<MapFit>> {
    let rows: Vec<BackbonePoint> = records.iter().flat_map(|swings| backbone(swings, 12)).collect();
    let largest =
        records.iter().max_by(|one, other| one.amplitudes()[0].total_cmp(&other.amplitudes()[0]));
    let Some(largest) = largest else { return vec![vec![]; laws.len()] };
    let mut springs: Vec<Spring> =
        laws.iter().filter_map(|law| law.parts).map(|parts| parts.0).collect();
    springs.sort_unstable();
    springs.dedup();
    let found = par_map(&springs, |spring| spring_starts(*spring, &rows, records, largest));
    par_map(laws, |law| {
        let Some((spring, loss)) = law.parts else { return vec![] };
        let Some(first) = guess(spring, loss, &rows, largest.centre[2]) else { return vec![] };
        let own = springs.iter().zip(&found).find(|(own, _)| **own == spring);
        let Some((_, SpringStarts { free, held })) = own else { return vec![] };
        let fits = free.iter().filter_map(|known| {
            let start = with_work_of((spring, loss), known, &first, largest)?;
            fit_map_from((spring, loss), records, &start, None)
        });
        let mut fits = distinct(fits.collect());
        // The turning points say no more of these than that they are possible: the samples decide.
        if !fits.is_empty() {
            fits.extend(held.iter().filter_map(|known| {
                let parameters = with_work_of((spring, loss), &known.parameters, &first, largest)?;
                Some(MapFit { parameters, ..known.clone() })
            }));
        }
        fits
    })
}

/// The fits whose chi-square is near the least, without those that are alike, the best first.
fn distinct(mut fits: Vec<MapFit>) -> Vec<MapFit> {
    fits.sort_by(|one, other| one.chi_square.total_cmp(&other.chi_square));
    let least = fits.first().map_or(0.0, |fit| fit.chi_square);
    fits.retain(|fit| fit.chi_square <= 1.5 * least + 10.0);
    fits.dedup_by(|one, other| {
        let pairs = one.parameters.iter().zip(&other.parameters);
        pairs.into_iter().all(|(one, other)| (one - other).abs() <= 0.02 * other.abs())
    });
    fits
}

/// Springs with viscous damping and dry friction to start from.
struct SpringStarts {
    /// The parameters of fits to the turning points.
    free: Vec<Vec<f64>>,
    /// Fits with the second number of the spring held, where the turning points do not determine it.
    held: Vec<MapFit>,
}

/// Searches the numbers of a spring.
fn spring_starts(
    spring: Spring,
    rows: &[BackbonePoint],
    records: &[&Swings],
    largest: &Swings,
) -> SpringStarts {
    let loss = Loss::ViscousAndCoulomb;
    let none = SpringStarts { free: vec![], held: vec![] };
    let Some(first) = guess(spring, loss, rows, largest.centre[2]) else { return none };
    let fit = |start: &Vec<f64>, held| fit_map_from((spring, loss), records, start, held);
    let starts = further_starts(spring, &first, largest);
    let fits = distinct(starts.iter().filter_map(|start| fit(start, None)).collect());
    let Some(best) = fits.first() else { return SpringStarts { free: vec![first], ..none } };
    let others = undetermined(spring, best, largest);
    // The second number of the spring stays, the first one follows the period.
    let held = others.iter().filter_map(|start| fit(start, Some(1))).collect();
    SpringStarts { free: fits.into_iter().map(|fit| fit.parameters).collect(), held }
}

/// The parameters of a law with the spring of a known one, which has viscous damping and dry friction, and its own guess of the loss
/// multiplied so that it does the same work in the middle of the record. A guess that takes too much would bring the law
/// to rest within the record, from where no search finds back. Returns `None` if the known law has no motion there.
fn with_work_of(
    (spring, loss): (Spring, Loss),
    known: &[f64],
    guess: &[f64],
    swings: &Swings,
) -> Option<Vec<f64>> {
    let numbers = known.len() - 2;
    if loss == Loss::ViscousAndCoulomb {
        return Some(known.to_vec());
    }
    let mut start = [&known[..numbers], &guess[numbers..]].concat();
    let amplitudes = swings.amplitudes();
    let amplitude = *amplitudes.get(amplitudes.len() / 2)?;
    let work = |loss, parameters: &[f64]| {
        let own = Numbers::new(spring, loss, parameters).symmetric_half_swing(amplitude);
        own.map(|[_, work]| work)
    };
    if let Some(coefficient) = start.get(numbers).copied() {
        let [wanted, own] = [work(Loss::ViscousAndCoulomb, known)?, work(loss, &start)?];
        let ratio = wanted / own;
        if ratio.is_finite() && ratio > 0.0 {
            start[numbers] = coefficient * ratio;
        }
    }
    Some(start)
}

/// The first guess and others: where the amplitude hardly changes, frequencies do not tell a quadratic spring or a power from a line.
fn further_starts(spring: Spring, first: &[f64], swings: &Swings) -> Vec<Vec<f64>> {
    let mut starts = vec![first.to_vec()];
    let amplitude = swings.amplitudes()[0];
    let mut add = |stiffness: f64, second: f64| {
        let mut other = first.to_vec();
        (other[0], other[1]) = (stiffness, second);
        starts.push(other);
    };
    match spring {
        Spring::Quadratic => {
            let size = first[0].powi(2) / amplitude;
            [0.02, -0.02, 0.2, -0.2].iter().for_each(|share| add(first[0], share * size));
        }
        Spring::Power => {
            let square = (std::f64::consts::PI / swings.half_period).powi(2);
            for exponent in [0.6, 1.01, 2.0] {
                add(square * amplitude.powf(1.0 - exponent), exponent);
            }
        }
        Spring::Linear | Spring::Duffing | Spring::Pendulum => {}
    }
    starts
}

/// Starts with other second numbers of a spring, if the turning points leave it undetermined: in a record whose amplitude hardly changes
/// only the shape of the swings tells it.
fn undetermined(spring: Spring, best: &MapFit, swings: &Swings) -> Vec<Vec<f64>> {
    let amplitude = swings.amplitudes()[0];
    let rate = std::f64::consts::PI / swings.half_period;
    // The second number relative to the force at the amplitude; of a power it is the exponent.
    let (unit, large, shares): (f64, f64, &[f64]) = match spring {
        Spring::Duffing => ((rate / amplitude).powi(2), 0.1, &[-0.4, -0.15, 0.15, 0.5, 1.5]),
        Spring::Quadratic => (rate.powi(2) / amplitude, 0.05, &[-0.3, -0.15, 0.15, 0.3]),
        Spring::Power => (1.0, 0.1, &[0.4, 0.6, 0.8, 1.2, 1.6, 2.2, 3.0]),
        Spring::Linear | Spring::Pendulum => return vec![],
    };
    if best.second_error <= large * unit {
        return vec![];
    }
    let start = |share: &f64| {
        let second = share * unit;
        let square = match spring {
            Spring::Duffing => rate.powi(2) - 0.75 * second * amplitude * amplitude,
            Spring::Quadratic => rate.powi(2) + 5.0 / 6.0 * (second * amplitude / rate).powi(2),
            _ => rate.powi(2) * amplitude.powf(1.0 - second),
        };
        let first = if spring == Spring::Power { square } else { square.max(0.0).sqrt() };
        let mut start = best.parameters.clone();
        (start[0], start[1]) = (first, second);
        start
    };
    shares.iter().map(start).collect()
}

/// The residuals of the turning points of a record, in units of their errors, appended to others.
fn map_residuals(
    numbers: &Numbers,
    swings: &Swings,
    [mut x, mut time, level, drift]: [f64; 4],
    residuals: &mut Vec<f64>,
) {
    let (mut count, mut work) = (0, 0.0);
    for point in &swings.points {
        while count < point.half_swings {
            let Some([next, duration, spent]) = numbers.next(x, work) else {
                // The law comes to rest: it stays there.
                (x, time, work) = (0.0, time + swings.half_period, 0.0);
                count += 1;
                continue;
            };
            (x, time, work) = (next, time + duration, spent);
            count += 1;
        }
        let centre = level + drift * (point.time - swings.middle);
        residuals.push((x + centre - point.value) / point.value_error);
        residuals.push((time - point.time) / point.time_error);
    }
}

/// Fits a law from these parameters, one of which may be held.
fn fit_map_from(
    (spring, loss): (Spring, Loss),
    records: &[&Swings],
    parameters: &[f64],
    held: Option<usize>,
) -> Option<MapFit> {
    const ITERATIONS: u64 = 30;
    let own = parameters.len();
    let mut start = parameters.to_vec();
    let scale = |value: &f64| if value.abs() > 1e-5 { value.abs() } else { 1e-2 };
    let mut scales: Vec<f64> = parameters.iter().map(scale).collect();
    for swings in records {
        let first = swings.points[0];
        let [level, drift, _] = swings.centre;
        let amplitude = swings.amplitudes()[0];
        let sign = if first.is_maximum { 1.0 } else { -1.0 };
        let coordinate = first.value - level - drift * (first.time - swings.middle);
        let coordinate = if coordinate * sign > 0.0 { coordinate } else { sign * amplitude };
        start.extend([coordinate, first.time, level, drift]);
        scales.extend([amplitude, swings.half_period, amplitude, amplitude / swings.half_period]);
    }
    let local = |values: &[f64], record: usize| -> Option<[f64; 4]> {
        values.get(own + 4 * record..)?.first_chunk::<4>().copied()
    };
    let residuals = |values: &[f64]| -> Option<DVector<f64>> {
        let numbers = Numbers::new(spring, loss, &values[..own]);
        let mut residuals = vec![];
        for (record, swings) in records.iter().enumerate() {
            map_residuals(&numbers, swings, local(values, record)?, &mut residuals);
        }
        let residuals = DVector::from_vec(residuals);
        residuals.iter().all(|value| value.is_finite()).then_some(residuals)
    };
    let linearised = |values: &[f64]| -> Option<Linearised> {
        const STEP: f64 = 1e-6;
        let at = residuals(values)?;
        let mut jacobian = DMatrix::zeros(at.len(), values.len());
        for index in (0..values.len()).filter(|index| Some(*index) != held) {
            let mut moved = values.to_vec();
            let step = STEP * scales[index];
            moved[index] += step;
            jacobian.set_column(index, &((residuals(&moved)? - &at) / step));
        }
        Some((at, jacobian))
    };
    let minimum = minimise(&start, ITERATIONS, linearised)?;
    let chi_square = minimum.square();
    let covariance = Covariance::new(&minimum.jacobian);
    // What a flat direction leaves out has no error.
    let second_error = match covariance.flat.is_empty() {
        true => covariance.matrix[(1, 1)].max(0.0).sqrt(),
        false => f64::INFINITY,
    };
    let starts = (0..records.len()).map(|record| local(&minimum.parameters, record));
    Some(MapFit {
        parameters: minimum.parameters[..own].to_vec(),
        starts: starts.collect::<Option<_>>()?,
        chi_square,
        second_error,
    })
}

/// The first guess of the parameters from the measured backbone: by regression of frequency and of decrement on
/// amplitude. `shift` is the multiple of the square of the amplitude by which the middle of the turning points moves.
pub(crate) fn guess(
    spring: Spring,
    loss: Loss,
    rows: &[BackbonePoint],
    shift: f64,
) -> Option<Vec<f64>> {
    let weights: Vec<f64> =
        rows.iter().map(|row| (row.frequency / row.frequency_error).powi(2)).collect();
    let column =
        |value: &dyn Fn(&BackbonePoint) -> f64| rows.iter().map(value).collect::<Vec<f64>>();
    let one = vec![1.0; rows.len()];
    let squares = column(&|row| row.frequency.powi(2));
    let relative: Vec<f64> =
        rows.iter().zip(&weights).map(|(row, weight)| weight / row.frequency.powi(4)).collect();
    let line = |columns: &[Vec<f64>], values: &[f64], weights: &[f64]| {
        regression(columns, values, weights).map(|(found, _)| found)
    };
    let mean = line(std::slice::from_ref(&one), &squares, &relative)?[0];
    let sloped = line(&[one.clone(), column(&|row| row.amplitude.powi(2))], &squares, &relative);
    let sloped = sloped.filter(|found| found[0] > 0.0).unwrap_or_else(|| vec![mean, 0.0]);
    let (mut parameters, frequency) = match spring {
        Spring::Linear => (vec![mean.sqrt()], mean.sqrt()),
        Spring::Duffing => (vec![sloped[0].sqrt(), 4.0 / 3.0 * sloped[1]], sloped[0].sqrt()),
        Spring::Quadratic => {
            // The middle of two turning points is -b A^2/(3 w^2).
            let shift = -3.0 * sloped[0] * shift;
            let size = (1.2 * sloped[0] * (-sloped[1]).max(0.0)).sqrt();
            let bent = if size > 0.0 { size.copysign(shift) } else { shift };
            (vec![sloped[0].sqrt(), bent], sloped[0].sqrt())
        }
        Spring::Pendulum => {
            let small =
                column(&|row| (row.frequency * (1.0 + row.amplitude.powi(2) / 16.0)).powi(2));
            let square = line(std::slice::from_ref(&one), &small, &relative)?[0];
            (vec![square.sqrt()], square.sqrt())
        }
        Spring::Power => {
            let logarithms = column(&|row| row.frequency.ln());
            let amplitudes = column(&|row| row.amplitude.ln());
            let found = line(&[one.clone(), amplitudes], &logarithms, &weights)?;
            let exponent = (2.0 * found[1] + 1.0).clamp(0.1, 9.0);
            // omega = 2 pi/T with T = 4 sqrt((n + 1)/(2 k)) A^((1 - n)/2) sqrt(pi) Gamma(1/(n + 1))/((n + 1) Gamma(1/(n + 1) + 1/2)).
            let m = 1.0 / (exponent + 1.0);
            let integral = std::f64::consts::PI.sqrt() * m * gamma(m) / gamma(m + 0.5);
            let unit = std::f64::consts::FRAC_PI_2 / integral / (0.5 * (exponent + 1.0)).sqrt();
            (vec![(found[0].exp() / unit).powi(2), exponent], mean.sqrt())
        }
    };
    // The decrement of a half swing: pi zeta A for viscous damping, 2 alpha for dry friction, (4/3) q A^2 for quadratic.
    let decrements = column(&|row| std::f64::consts::PI * row.damping * row.amplitude);
    let weights: Vec<f64> = rows
        .iter()
        .map(|row| (std::f64::consts::PI * row.damping_error * row.amplitude).powi(-2))
        .collect();
    let amplitudes = column(&|row| row.amplitude);
    let alone = |values: Vec<f64>| line(&[values], &decrements, &weights).map(|found| found[0]);
    let has_frequency = spring != Spring::Power;
    let viscous = if has_frequency { 1.0 } else { 2.0 * frequency };
    let dry = if has_frequency { 1.0 } else { frequency * frequency };
    match loss {
        Loss::None => {}
        Loss::Viscous => parameters.push(viscous * alone(amplitudes)? / std::f64::consts::PI),
        Loss::Coulomb => parameters.push(dry * 0.5 * alone(one)?),
        Loss::Quadratic => {
            parameters.push(0.75 * alone(column(&|row| row.amplitude.powi(2)))?);
        }
        Loss::ViscousAndCoulomb => {
            let found = line(&[amplitudes, one], &decrements, &weights)?;
            parameters.push(viscous * found[0] / std::f64::consts::PI);
            parameters.push(dry * 0.5 * found[1]);
        }
        Loss::Power => {
            let positive = decrements.iter().map(|value| value.max(1e-12 * amplitudes[0]).ln());
            let positive: Vec<f64> = positive.collect();
            let relative: Vec<f64> = weights
                .iter()
                .zip(&decrements)
                .map(|(weight, value)| weight * value.powi(2))
                .collect();
            let logarithms = column(&|row| row.amplitude.ln());
            let found = line(&[one, logarithms], &positive, &relative)?;
            let exponent = found[1].clamp(0.1, 4.0);
            // Delta = r A^p w^(p - 2) I,  I = int_0^pi sin^(p + 1) = sqrt(pi) Gamma(p/2 + 1)/Gamma(p/2 + 3/2); through the middle row.
            let middle = &rows[rows.len() / 2];
            let integral = std::f64::consts::PI.sqrt() * gamma(0.5 * exponent + 1.0)
                / gamma(0.5 * exponent + 1.5);
            let decrement = (found[0] + found[1] * middle.amplitude.ln()).exp();
            let unit = middle.amplitude.powf(exponent) * frequency.powf(exponent - 2.0) * integral;
            parameters.extend([decrement / unit, exponent]);
        }
    }
    parameters.iter().all(|value| value.is_finite()).then_some(parameters)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_swings_are_those_of_the_closed_forms() {
        let pendulum = Numbers::new(Spring::Pendulum, Loss::Viscous, &[2.0, 0.01]);
        let energy = pendulum.potential(1.5);
        let [time, _] = pendulum.half_swing([[-1.5, energy], [1.5, energy]]).unwrap();
        let exact = ellip::ellipk(0.75_f64.sin().powi(2)).unwrap();
        assert!((time - exact).abs() < 1e-12, "{time} {exact}");
        // Dry friction takes 2 alpha from the amplitude of a linear spring.
        let dry = Numbers::new(Spring::Linear, Loss::Coulomb, &[3.0, 0.05]);
        let [next, ..] = dry.next(1.0, 0.0).unwrap();
        assert!((next + 0.9).abs() < 1e-12, "{next}");
        // Both turning points of x + x^2/5 have the same energy.
        let quadratic = Numbers::new(Spring::Quadratic, Loss::None, &[1.0, 0.2]);
        let low = quadratic.turning_point(quadratic.potential(1.0), -1.0).unwrap();
        assert!((quadratic.potential(low) - quadratic.potential(1.0)).abs() < 1e-14);
    }
}

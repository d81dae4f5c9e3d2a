//! Laws from a backbone table: frequency, and perhaps damping, against amplitude.
//!
//! The table may come from free decays, as in the benchmarks of bolted structures, or from phase resonance tests. Springs
//! are compared by their exact frequencies `omega(A) = pi/(T/2)`, losses by `zeta(A) = W/(pi A dE/dA)` with the best spring.
//!
//! ```text
//! BIC = N ln(RSS/N) + k ln N                     relative errors, found from the residuals
//! ```

use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use crate::fit::answer::Estimate;
use crate::fit::backbone::BackbonePoint;
use crate::fit::closed_forms::{Numbers, guess};
use crate::fit::laws::{Law, Loss, Spring};
use crate::fit::least_squares::{Covariance, Minimum, minimise};

/// One row of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableRow {
    /// The amplitude.
    pub amplitude: f64,
    /// The angular frequency.
    pub frequency: f64,
    /// The damping ratio.
    pub damping: Option<f64>,
}

/// A law fitted to a table.
#[derive(Clone, Debug)]
pub struct TableFit {
    /// The law.
    pub law: Law,
    /// The parameters.
    pub estimates: Vec<Estimate>,
    /// The largest relative deviation of the frequency.
    pub worst_frequency: f64,
    /// The criterion of Schwarz.
    pub bic: f64,
}

/// The answer for a table.
#[derive(Clone, Debug)]
pub struct TableAnswer {
    /// The springs, each without a loss, the best first.
    pub springs: Vec<TableFit>,
    /// The laws of the best spring with each loss, the best first; empty if no damping is given.
    pub laws: Vec<TableFit>,
}

/// The reason why a table has no law.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TableError {
    /// There are too few rows.
    #[error("the table has {0} rows; at least 5 are needed")]
    TooFew(usize),
    /// A row has a number that is not positive.
    #[error("row {0}, counted from 1: amplitude and frequency must be positive numbers")]
    NotPositive(usize),
    /// The amplitudes are all alike.
    #[error(
        "the amplitudes range from {from} to {to} only: frequency cannot be told against amplitude"
    )]
    Narrow {
        /// The smallest amplitude.
        from: f64,
        /// The largest amplitude.
        to: f64,
    },
    /// No law could be fitted.
    #[error("no spring has frequencies near those of the table")]
    NoFit,
}

impl TableError {
    /// A way forward.
    pub fn help(&self) -> &'static str {
        match self {
            Self::TooFew(_) => "add rows at further amplitudes",
            Self::NotPositive(_) => {
                "give amplitudes and frequencies as positive numbers, frequencies in rad/s or in Hz throughout"
            }
            Self::Narrow { .. } => "measure over a wider range of amplitudes",
            Self::NoFit => "look for rows that do not belong to one branch",
        }
    }
}

/// Fits springs and losses to a table.
///
/// # Errors
/// [`TableError`].
///
/// ```
/// use lindstedt_fit::fit::laws::Spring;
/// use lindstedt_fit::fit::tables::{TableRow, fit_table};
///
/// // The first approximation of Duffing's equation, omega^2 = 4 + 3/4 A^2, with zeta = 0.01.
/// let rows: Vec<TableRow> = (1..20)
///     .map(|index| 0.05 * f64::from(index))
///     .map(|amplitude| TableRow { amplitude, frequency: (4.0 + 0.75 * amplitude * amplitude).sqrt(), damping: None })
///     .collect();
/// let answer = fit_table(&rows, false)?;
/// assert_eq!(answer.springs[0].law.parts.map(|parts| parts.0), Some(Spring::Duffing));
/// # Ok::<(), lindstedt_fit::fit::tables::TableError>(())
/// ```
pub fn fit_table(rows: &[TableRow], is_angle: bool) -> Result<TableAnswer, TableError> {
    const FEWEST: usize = 5;
    const NARROW: f64 = 1.05;
    if rows.len() < FEWEST {
        return Err(TableError::TooFew(rows.len()));
    }
    let is_positive = |value: f64| value.is_finite() && value > 0.0;
    let wrong = |row: &TableRow| !is_positive(row.amplitude) || !is_positive(row.frequency);
    if let Some(place) = rows.iter().position(wrong) {
        return Err(TableError::NotPositive(place + 1));
    }
    let amplitudes = || rows.iter().map(|row| row.amplitude);
    let (from, to) = (amplitudes().fold(f64::INFINITY, f64::min), amplitudes().fold(0.0, f64::max));
    if to < NARROW * from {
        return Err(TableError::Narrow { from, to });
    }
    let springs = Spring::ALL.into_iter().filter(|spring| is_angle || *spring != Spring::Pendulum);
    let springs =
        ordered(springs.filter_map(|spring| fit_parts(rows, (spring, Loss::None), false)));
    let best = springs.first().and_then(|fit| fit.law.parts).ok_or(TableError::NoFit)?.0;
    let laws = match rows.iter().any(|row| row.damping.is_some()) {
        true => {
            ordered(Loss::ALL.into_iter().filter_map(|loss| fit_parts(rows, (best, loss), true)))
        }
        false => vec![],
    };
    Ok(TableAnswer { springs, laws })
}

fn ordered(fits: impl Iterator<Item = TableFit>) -> Vec<TableFit> {
    let mut fits: Vec<TableFit> = fits.collect();
    fits.sort_by(|one, other| one.bic.total_cmp(&other.bic));
    fits
}

/// Fits a spring to the frequencies, or a loss with its spring to the frequencies and dampings.
fn fit_parts(
    rows: &[TableRow],
    (spring, loss): (Spring, Loss),
    with_damping: bool,
) -> Option<TableFit> {
    /// The weight of the dampings beside that of the frequencies, so that they leave the spring as it is.
    const SHARE: f64 = 0.01;
    /// The share of the mean damping below which a damping has no relative error of its own.
    const LEAST: f64 = 0.01;
    let law = Law::from_parts(spring, loss).ok()?;
    let of_spring = Law::from_parts(spring, Loss::None).ok()?.parameters.len();
    let first = first_guess(rows, spring, loss)?;
    let typical = typical(rows);
    // Relative deviations of the frequencies, then those of the dampings.
    let residuals = |values: &[f64]| -> Option<DVector<f64>> {
        let numbers = Numbers::new(spring, loss, values);
        let (mut residuals, mut dampings) = (vec![], vec![]);
        for row in rows {
            let [frequency, damping] = numbers.frequency_and_damping(row.amplitude)?;
            residuals.push(frequency / row.frequency - 1.0);
            let measured = row.damping.filter(|_| with_damping);
            dampings.extend(measured.map(|measured| {
                SHARE * (damping - measured) / measured.abs().max(LEAST * typical)
            }));
        }
        residuals.extend(dampings);
        Some(DVector::from_vec(residuals))
    };
    let linearised = |values: &[f64]| {
        const STEP: f64 = 1e-5;
        let at = residuals(values)?;
        let mut jacobian = DMatrix::zeros(at.len(), values.len());
        for column in 0..values.len() {
            let [mut above, mut below] = [values.to_vec(), values.to_vec()];
            let step = STEP * first[column].abs().max(1e-6);
            above[column] += step;
            below[column] -= step;
            jacobian
                .set_column(column, &((residuals(&above)? - residuals(&below)?) / (2.0 * step)));
        }
        Some((at, jacobian))
    };
    let Minimum { parameters, residuals, jacobian, .. } = minimise(&first, 100, linearised)?;
    let (frequencies, dampings) = residuals.as_slice().split_at(rows.len());
    let square = |own: &[f64]| own.iter().map(|own| own * own).sum::<f64>();
    let (counted, width) = match with_damping {
        true => (dampings, parameters.len() - of_spring),
        false => (frequencies, of_spring),
    };
    let number = counted.len() as f64;
    let least = number * f64::EPSILON * f64::EPSILON;
    let bic = number * (square(counted).max(least) / number).ln() + width as f64 * number.ln();
    // Frequencies and dampings have errors of their own: the covariance is that of the scatter of each.
    let inverse = Covariance::new(&jacobian).matrix;
    let scatter =
        |own: &[f64], width: usize| square(own) / (own.len() as f64 - width as f64).max(1.0);
    let weights =
        [scatter(frequencies, of_spring), scatter(dampings, parameters.len() - of_spring)];
    let scaled = DMatrix::from_fn(jacobian.nrows(), jacobian.ncols(), |row, column| {
        jacobian[(row, column)] * weights[usize::from(row >= rows.len())].sqrt()
    });
    let covariance = &inverse * (scaled.transpose() * &scaled) * &inverse;
    let estimates =
        law.parameters.iter().zip(&parameters).enumerate().map(|(index, (name, value))| Estimate {
            name: name.to_string(),
            value: *value,
            error: covariance[(index, index)].max(0.0).sqrt(),
        });
    let worst_frequency = frequencies.iter().fold(0.0_f64, |worst, own| worst.max(own.abs()));
    Some(TableFit { estimates: estimates.collect(), worst_frequency, bic, law })
}

/// The mean damping ratio.
fn typical(rows: &[TableRow]) -> f64 {
    let dampings: Vec<f64> = rows.iter().filter_map(|row| row.damping).map(f64::abs).collect();
    (dampings.iter().sum::<f64>() / dampings.len().max(1) as f64).max(f64::MIN_POSITIVE)
}

fn first_guess(rows: &[TableRow], spring: Spring, loss: Loss) -> Option<Vec<f64>> {
    let mut points: Vec<BackbonePoint> = rows
        .iter()
        .map(|row| BackbonePoint {
            time: 0.0,
            amplitude: row.amplitude,
            amplitude_error: 0.0,
            frequency: row.frequency,
            frequency_error: 1e-3 * row.frequency,
            damping: row.damping.unwrap_or(0.0),
            damping_error: typical(rows),
        })
        .collect();
    points.sort_by(|one, other| one.amplitude.total_cmp(&other.amplitude));
    guess(spring, loss, &points, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(spring: Spring, loss: Loss, parameters: &[f64]) -> Vec<TableRow> {
        let numbers = Numbers::new(spring, loss, parameters);
        (1..30)
            .map(|index| 0.03 * f64::from(index))
            .map(|amplitude| {
                let [frequency, damping] = numbers.frequency_and_damping(amplitude).unwrap();
                // The error of a table with five digits.
                let ripple = 1e-5 * (7.0 * amplitude / 0.03).sin();
                let frequency = frequency * (1.0 + ripple);
                TableRow { amplitude, frequency, damping: Some(damping * (1.0 + 300.0 * ripple)) }
            })
            .collect()
    }

    #[test]
    fn a_duffing_backbone_is_found_within_a_thousandth() {
        let rows = table(Spring::Duffing, Loss::ViscousAndCoulomb, &[3.0, 2.5, 0.004, 0.0003]);
        let answer = fit_table(&rows, false).unwrap();
        let best = &answer.springs[0];
        assert_eq!(best.law.parts.unwrap().0, Spring::Duffing, "{:?}", answer.springs);
        assert!(best.worst_frequency < 1e-3);
        assert!((best.estimates[1].value / 2.5 - 1.0).abs() < 1e-3, "{:?}", best.estimates);
        let best = &answer.laws[0];
        assert_eq!(best.law.parts.unwrap().1, Loss::ViscousAndCoulomb, "{:?}", answer.laws);
        assert!((best.estimates[2].value / 0.004 - 1.0).abs() < 1e-2, "{:?}", best.estimates);
        assert!((best.estimates[3].value / 0.0003 - 1.0).abs() < 1e-2, "{:?}", best.estimates);
    }

    #[test]
    fn each_spring_and_loss_is_recognised() {
        let springs: [(Spring, &[f64]); 3] =
            [(Spring::Linear, &[2.0]), (Spring::Pendulum, &[2.0]), (Spring::Power, &[2.0, 1.5])];
        for (spring, parameters) in springs {
            let answer = fit_table(&table(spring, Loss::None, parameters), true).unwrap();
            assert_eq!(answer.springs[0].law.parts.unwrap().0, spring, "{:?}", answer.springs);
        }
        let losses: [(Loss, &[f64]); 3] = [
            (Loss::Viscous, &[2.0, 0.01]),
            (Loss::Coulomb, &[2.0, 0.001]),
            (Loss::Quadratic, &[2.0, 0.02]),
        ];
        for (loss, parameters) in losses {
            let answer = fit_table(&table(Spring::Linear, loss, parameters), false).unwrap();
            assert_eq!(answer.laws[0].law.parts.unwrap().1, loss, "{:?}", answer.laws);
        }
    }

    #[test]
    fn mistakes_are_named() {
        let mut rows = table(Spring::Linear, Loss::None, &[2.0]);
        assert_eq!(fit_table(&rows[..3], false).unwrap_err(), TableError::TooFew(3));
        rows[4].amplitude = -1.0;
        assert_eq!(fit_table(&rows, false).unwrap_err(), TableError::NotPositive(5));
        rows.iter_mut().for_each(|row| row.amplitude = 1.0);
        assert!(matches!(fit_table(&rows, false).unwrap_err(), TableError::Narrow { .. }));
    }
}

//! Comparison of all methods for one impact with the same true motion, one row each.
//!
//! In: a [`Setup`] without a method. Out: the paper's two readings, then each method of `derive` at
//! its lowest order that passes, else at its best, and the reason of each that has no row.

use super::closed_form::{PhaseReading, paper};
use super::error::ImpactError;
use super::judge::TrueImpact;
use super::phases::ThreePhases;
use super::setup::{ImpactSymbols, Setup};
use super::trial::{Trial, worst};
use crate::solution::{Degrees, Method};
use crate::verify::Verdict;

/// A table of methods.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ImpactComparison {
    /// The problem that was solved.
    pub setup: Setup,
    /// The equation on which the closed forms are verified.
    pub equation: String,
    /// The symbols of this equation.
    pub letters: ImpactSymbols,
    /// The equilibrium of the swing, in the unit of x.
    pub equilibrium: f64,
    /// The start of the cycle: the release, or the turning point of a motion released inside the
    /// barrier.
    pub turning_point: f64,
    /// The rows that have numbers: the paper's readings first, then the methods in the order of
    /// [`Method::ALL`].
    pub rows: Vec<ImpactRow>,
    /// The methods without numbers, with the reason of each.
    pub refused: Vec<(ImpactMethod, String)>,
    /// lambda of the contact; zero if it loses no energy.
    pub damping: f64,
    /// Runge-Kutta on the original equation.
    pub truth: TrueImpact,
}

/// The source of the three phases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImpactMethod {
    /// A reading of the paper.
    Reading(PhaseReading),
    /// A method of `derive`.
    Derived(Method),
}

impl ImpactMethod {
    /// The name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reading(reading) => reading.name(),
            Self::Derived(method) => method.name(),
        }
    }

    /// The name in tables.
    pub fn title(self) -> &'static str {
        match self {
            Self::Reading(PhaseReading::Paper) => "Paper",
            Self::Reading(_) => "Paper, speed by energy",
            Self::Derived(method) => method.title(),
        }
    }
}

/// A row of the table.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ImpactRow {
    /// The method of the row.
    pub method: ImpactMethod,
    /// The order of the law; `None` if it has none.
    pub order: Option<u32>,
    /// The degrees of an approximant.
    pub degrees: Option<Degrees>,
    /// The closed forms.
    pub phases: ThreePhases,
    /// The relative errors of time to contact, speed, penetration, duration and period.
    pub errors: [f64; 5],
    /// The largest deviation in approach, contact and return, each on its own clock: of the flights
    /// over the amplitude, of the contact over the depth.
    pub deviations: [f64; 3],
}

impl ImpactRow {
    /// The method with its order, as tables print it.
    pub fn title(&self) -> String {
        let title = self.method.title();
        match (self.degrees, self.order) {
            (Some(degrees), _) => format!("{title} {degrees}"),
            (None, Some(order)) => format!("{title}, order {order}"),
            (None, None) => title.to_owned(),
        }
    }

    /// The largest of its errors and deviations, in size.
    pub fn worst(&self) -> f64 {
        worst(self.errors.iter().chain(&self.deviations))
    }

    /// Whether every number and every phase is within the tolerance.
    pub fn verdict(&self, tolerance: f64) -> Verdict {
        Verdict::from_passed(self.worst() <= tolerance)
    }
}

/// Compares every method on one impact.
///
/// # Errors
/// As [`solve`](super::solve()), but a method that does not apply is a row of its own.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{Setup, compare};
///
/// let table = compare(Setup { tolerance: 1e-3, ..Setup::default() })?;
/// let best = table.rows.iter().map(|row| row.worst()).fold(f64::INFINITY, f64::min);
/// assert!(best < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare(setup: Setup) -> Result<ImpactComparison, ImpactError> {
    Trial::run(&setup, |trial| {
        let (mut rows, mut refused) = (Vec::new(), Vec::new());
        let row = |method, order, degrees, phases: ThreePhases| {
            let [t, v, d, duration, period, approach, contact, back] = trial.errors(&phases);
            ImpactRow {
                method,
                order,
                degrees,
                phases,
                errors: [t, v, d, duration, period],
                deviations: [approach, contact, back],
            }
        };
        match paper(trial) {
            Ok((law, phases)) => {
                for (reading, phases) in phases {
                    let order = (reading == PhaseReading::Paper).then_some(law.order);
                    rows.push(row(ImpactMethod::Reading(reading), order, None, phases));
                }
            }
            Err(error) => {
                refused.push((ImpactMethod::Reading(PhaseReading::Paper), error.to_string()))
            }
        }
        for method in Method::ALL {
            let name = ImpactMethod::Derived(method);
            match trial.derived(&[method]) {
                (Some(found), tried) => {
                    let solution = &found.flight.solution;
                    // The order that was chosen among several.
                    let several = tried.iter().filter(|attempt| attempt.error.is_ok()).count() > 1;
                    let order = (several || setup.order.is_some()).then_some(solution.order);
                    rows.push(row(name, order, solution.degrees, found.phases));
                }
                (None, tried) => {
                    let reason = tried.iter().find_map(|attempt| attempt.error.as_ref().err());
                    refused.push((name, reason.cloned().unwrap_or_default()));
                }
            }
        }
        Ok(ImpactComparison {
            setup: setup.clone(),
            equation: trial.equations.judged.clone(),
            letters: trial.equations.letters,
            equilibrium: trial.equations.equilibrium,
            turning_point: trial.turning_point,
            rows,
            refused,
            damping: trial.collision.damping,
            truth: trial.truth.clone(),
        })
    })
}

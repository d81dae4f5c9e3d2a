//! Kind `motion`: any equation or mechanism followed from its start.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Kind;
use super::number::Map;
use crate::report::TrajectoryReport;
use crate::system::Integrator;
use crate::trajectory::in_words;

/// A motion in numbers, of an equation of motion or of a mechanism of several coordinates. Units are those of the values given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct MotionDocument {
    /// The kind of document.
    #[schemars(extend("const" = Kind::Motion.schema()))]
    pub schema: String,
    /// The coordinates.
    pub coordinates: Vec<String>,
    /// The equations of motion, each `... = 0`.
    pub equations: Vec<String>,
    /// The value of every parameter.
    pub parameters: Map<f64>,
    /// Coordinates and velocities at t = 0.
    pub start: Map<f64>,
    /// By which integrator it was followed: `taylor` or `runge-kutta`.
    pub integrator: String,
    /// Coordinates and velocities at the times asked for, or at 21 equally spaced ones.
    pub samples: Vec<MotionSample>,
    /// Those at the end.
    pub final_state: MotionSample,
    /// The account of the energy; null for an equation without energies.
    pub energy: Option<EnergyAccount>,
    /// The largest difference from the other integrator, over the largest displacement; null where it was not asked for.
    pub difference: Option<f64>,
    /// Where dry friction holds it at rest: from when until when.
    pub held: Vec<[f64; 2]>,
    /// Why it ends where it does.
    pub stopped: String,
    /// Whether it was followed as long as asked.
    pub complete: bool,
}

/// A state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct MotionSample {
    /// The time.
    pub t: f64,
    /// Coordinates and velocities by name: `x`, `x'`.
    pub state: Map<f64>,
}

/// h = sum q' dL/dq' - L, the energy where nothing depends on the time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct EnergyAccount {
    /// At the start.
    pub start: f64,
    /// At the end.
    pub end: f64,
    /// The work of forces, dampers and moving constraints in between.
    pub work: f64,
    /// The largest part not accounted for at any time, over the largest energy.
    pub residual: f64,
}

/// The document of kind `motion`.
///
/// ```
/// use lindstedt::Oscillator;
/// use lindstedt::report::TrajectoryReport;
/// use lindstedt::trajectory::Course;
///
/// let mut course = Course::of_equation(&Oscillator::parse("x'' + x = 0")?);
/// course.begin("x".into(), 1.0)?;
/// let motion = course.follow()?;
/// let document = lindstedt::export::json::motion(&TrajectoryReport { motion: &motion, judge: None, samples: &[] });
/// assert!(document.complete && document.samples.len() == 21);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn motion(report: &TrajectoryReport) -> MotionDocument {
    let motion = report.motion;
    let course = &motion.course;
    let named = |state: &[f64]| {
        let names = course.rates.states.iter().map(ToString::to_string);
        names.zip(state.iter().copied()).collect()
    };
    let sample = |t: f64| {
        Some(MotionSample {
            t,
            state: named(&motion.at(t)?),
        })
    };
    let start = MotionSample {
        t: 0.0,
        state: named(&course.start),
    };
    MotionDocument {
        schema: Kind::Motion.schema().to_owned(),
        coordinates: course.coordinates.iter().map(ToString::to_string).collect(),
        equations: course.equations.iter().map(|left| format!("{left} = 0")).collect(),
        parameters: course
            .values
            .iter()
            .map(|(name, value)| (name.to_string(), *value))
            .collect(),
        start: start.state.clone(),
        integrator: match motion.integrator {
            Integrator::Taylor => "taylor",
            Integrator::RungeKutta => "runge-kutta",
        }
        .to_owned(),
        samples: report.times().into_iter().filter_map(sample).collect(),
        final_state: sample(motion.end()).unwrap_or(start),
        energy: motion.balance.map(|balance| EnergyAccount {
            start: balance.start,
            end: balance.end,
            work: balance.work,
            residual: balance.residual,
        }),
        difference: report.judge.map(|judge| motion.difference(judge)),
        held: motion.held().collect(),
        stopped: in_words(motion.reason()).to_owned(),
        complete: motion.is_complete(),
    }
}

//! Kind `motion`: any equation or mechanism followed from its start.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::{Map, named, texts};
use crate::event::StateEvent;
use crate::report::MotionSweep;
use crate::report::TrajectoryReport;
use crate::system::{Integrator, PathEnd};
use crate::trajectory::{
    Attractor, Crossing, EventOccurrence, Fate, Impact, PoincareSection, Trajectory,
    TrajectoryRequest, WallRest, in_words,
};
use crate::wall::Wall;

/// A motion in numbers, of an equation of motion or of a mechanism of several coordinates. Units
/// are those of the values given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct MotionDocument {
    /// The kind of document.
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
    /// The states on the section; null where none was asked for.
    pub section: Option<SectionDocument>,
    /// Those at the end.
    pub final_state: MotionSample,
    /// The account of the energy; null for an equation whose inertia depends on the position, and
    /// without a value for a letter of the energies that cancels in the equations of motion.
    pub energy: Option<EnergyAccount>,
    /// The largest difference from the other integrator, over the largest displacement; null where
    /// it was not asked for.
    pub difference: Option<f64>,
    /// The time until which the states are known to six digits; beyond it a start displaced by
    /// 1e-12 of it leads elsewhere. Left out where they are known to the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub known_until: Option<f64>,
    /// The largest Lyapunov exponent. Left out where the states are known to the end and it was not asked
    /// for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lyapunov: Option<LyapunovDocument>,
    /// The stretches of time, from when until when, on which dry friction holds something: at rest,
    /// on a belt or on another body.
    pub held: Vec<[f64; 2]>,
    /// Static over sliding friction, a formula; left out where it was not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub static_friction: Option<String>,
    /// The walls with the impacts on them; left out without a wall.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub walls: Option<WallsDocument>,
    /// The events; left out without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub events: Option<EventsDocument>,
    /// Why it ends where it does.
    pub stopped: String,
    /// Whether it was followed as long as asked, its energy is accounted for and the other
    /// integrator, where asked for, agrees.
    pub complete: bool,
}

/// A state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct MotionSample {
    /// The time.
    pub t: f64,
    /// Coordinates and velocities by name: `x`, `x'`.
    pub state: Map<f64>,
}

/// Coordinates and velocities by their names.
fn states(course: &TrajectoryRequest, state: &[f64]) -> Map<f64> {
    named(course.rates.states.iter().zip(state.iter().copied()))
}

impl MotionSample {
    fn new(course: &TrajectoryRequest, t: f64, state: &[f64]) -> Self {
        Self { t, state: states(course, state) }
    }
}

/// Poincare's section.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "Section"))]
pub struct SectionDocument {
    /// The time between two states, a formula; null where it is the zeros of `rising` that count.
    pub every: Option<String>,
    /// What grows through zero, a formula; null where it is the time that counts.
    pub rising: Option<String>,
    /// From when on the motion is looked at.
    pub after: f64,
    /// The states, in order.
    pub states: Vec<MotionSample>,
    /// The times at which the motion turns back on the section: it touches and does not cross it,
    /// so that they are no states.
    pub touches: Vec<f64>,
}

/// h = sum q' dL/dq' - L, the energy where nothing depends on the time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct EnergyAccount {
    /// At the start.
    pub start: f64,
    /// At the end.
    pub end: f64,
    /// The work of forces, dampers and moving constraints in between.
    pub work: f64,
    /// The work of each of them by its name: a term of the equation, as it stands on the left side;
    /// `Q_x`, `dissipation`.
    pub works: Map<f64>,
    /// The largest part not accounted for at any time, over the largest energy.
    pub residual: f64,
}

/// The largest Lyapunov exponent of a motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "LyapunovExponent"))]
pub struct LyapunovDocument {
    /// The exponent, per unit of time.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// The time from which on the motion counts.
    pub from: f64,
}

/// Rigid walls, the impacts on them and the rests.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct WallsDocument {
    /// The walls.
    pub walls: Vec<WallDocument>,
    /// The impacts in order; of an accumulation those before its sum.
    pub impacts: Vec<ImpactDocument>,
    /// The stretches of time on which the motion rests on a wall.
    pub rests: Vec<WallRestDocument>,
    /// The first time at which several walls were hit at once and the order of the impacts matters;
    /// left out if there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order_matters: Option<f64>,
}

/// A rigid wall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "Wall"))]
pub struct WallDocument {
    /// The gap, zero at the wall and positive in front of it.
    pub gap: String,
    /// The coefficient of restitution.
    pub restitution: String,
}

/// An impact on a wall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "WallImpact"))]
pub struct ImpactDocument {
    /// The time.
    pub t: f64,
    /// The wall, counted from 0.
    pub wall: usize,
    /// The rate at which the gap closes before the impact: a speed where the gap is a distance.
    pub speed: f64,
    /// The speed at which it opens after the impact; 0 for the one after which the rest of an
    /// accumulation is summed.
    pub departure: f64,
    /// The energy that the impact takes; null where no energy is accounted for.
    pub energy_lost: Option<f64>,
}

/// A stretch of time on which a motion rests on a wall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "WallRest"))]
pub struct WallRestDocument {
    /// The wall, counted from 0.
    pub wall: usize,
    /// The time at which it begins.
    pub from: f64,
    /// The time at which the wall no longer presses, or the motion ends.
    pub until: f64,
    /// Whether infinitely many impacts came before it.
    pub after_chatter: bool,
}

/// The events of a motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct EventsDocument {
    /// The events.
    pub events: Vec<EventDocument>,
    /// The times at which they took place, in order.
    pub occurrences: Vec<EventOccurrenceDocument>,
    /// The first time at which several events took place at once and their order matters; left out if
    /// there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order_matters: Option<f64>,
}

/// An event.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "Event"))]
pub struct EventDocument {
    /// The expression that grows through zero there.
    pub guard: String,
    /// Whether the event takes place as well where the guard falls through zero.
    pub both_ways: bool,
    /// The states that are set, each with the formula of its new value.
    pub set: Map<String>,
}

/// An event that took place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "EventOccurrence"))]
pub struct EventOccurrenceDocument {
    /// The time.
    pub t: f64,
    /// The event, counted from 0.
    pub event: usize,
    /// Coordinates and velocities before it.
    pub before: Map<f64>,
    /// Coordinates and velocities behind it.
    pub after: Map<f64>,
    /// The energy that the event takes, negative where it gives some; null where no energy is accounted for.
    pub energy_lost: Option<f64>,
}

impl EventsDocument {
    fn new(motion: &Trajectory) -> Self {
        let course = &motion.course;
        let occurrence = |event: &EventOccurrence| EventOccurrenceDocument {
            t: event.time,
            event: event.event,
            before: states(course, &event.before),
            after: states(course, &event.after),
            energy_lost: event.loss,
        };
        Self {
            events: course.events.iter().map(EventDocument::new).collect(),
            occurrences: motion.events.occurrences.iter().map(occurrence).collect(),
            order_matters: motion.events.order_matters,
        }
    }
}

impl EventDocument {
    pub(super) fn new(event: &StateEvent) -> Self {
        Self {
            guard: event.guard.to_string(),
            both_ways: event.both_ways,
            set: named(event.assignments.iter().map(|(state, value)| (state, value.to_string()))),
        }
    }
}

impl WallDocument {
    pub(super) fn new(wall: &Wall) -> Self {
        Self { gap: wall.gap.to_string(), restitution: wall.restitution.to_string() }
    }
}

impl WallsDocument {
    fn new(motion: &Trajectory) -> Self {
        let record = &motion.walls;
        let impact = |impact: &Impact| ImpactDocument {
            t: impact.time,
            wall: impact.wall,
            speed: impact.speed,
            departure: impact.departure,
            energy_lost: impact.loss,
        };
        let rest = |rest: &WallRest| WallRestDocument {
            wall: rest.wall,
            from: rest.from,
            until: rest.until,
            after_chatter: rest.after_chatter,
        };
        Self {
            walls: motion.course.walls.iter().map(WallDocument::new).collect(),
            impacts: record.impacts.iter().map(impact).collect(),
            rests: record.rests.iter().map(rest).collect(),
            order_matters: record.order_matters,
        }
    }
}

/// The document of kind `motion`.
///
/// ```
/// use lindstedt::Oscillator;
/// use lindstedt::report::TrajectoryReport;
/// use lindstedt::trajectory::TrajectoryRequest;
///
/// let mut course = TrajectoryRequest::of_equation(&Oscillator::parse("x'' + x = 0")?);
/// course.begin("x".into(), 1.0)?;
/// let motion = course.follow()?;
/// let document = lindstedt::export::json::motion(&TrajectoryReport { motion: &motion, judge: None, samples: &[], known_until: None, lyapunov: None });
/// assert!(document.complete && document.samples.len() == 21);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn motion(report: &TrajectoryReport) -> MotionDocument {
    let motion = report.motion;
    let course = &motion.course;
    let sample = |t: f64| Some(MotionSample::new(course, t, &motion.states_at(t)?));
    let start = MotionSample::new(course, 0.0, &course.start);
    MotionDocument {
        schema: DocumentKind::Motion.schema().to_owned(),
        coordinates: texts(&course.coordinates),
        equations: course.equations.iter().map(|left| format!("{left} = 0")).collect(),
        parameters: named(course.values.iter().map(|(name, value)| (name, *value))),
        start: start.state.clone(),
        integrator: match motion.integrator {
            Integrator::Taylor => "taylor",
            Integrator::RungeKutta => "runge-kutta",
        }
        .to_owned(),
        section: course.section.as_ref().map(|section| {
            section_document(course, section, (motion.crossings(), motion.touches()))
        }),
        samples: report.times().into_iter().filter_map(sample).collect(),
        final_state: sample(motion.end()).unwrap_or(start),
        energy: motion.balance.as_ref().map(|balance| EnergyAccount {
            start: balance.start,
            end: balance.end,
            work: balance.work,
            works: balance.works.iter().cloned().collect(),
            residual: balance.residual,
        }),
        difference: report.judge.map(|judge| motion.difference(judge)),
        known_until: report.known_until,
        lyapunov: report.lyapunov.map(|exponent| LyapunovDocument {
            value: exponent.value,
            standard_error: exponent.error,
            from: exponent.from,
        }),
        held: motion.sticking_intervals().collect(),
        static_friction: course.static_friction.as_ref().map(ToString::to_string),
        walls: (!course.walls.is_empty()).then(|| WallsDocument::new(motion)),
        events: (!course.events.is_empty()).then(|| EventsDocument::new(motion)),
        stopped: in_words(motion.reason()).to_owned(),
        complete: report.is_complete(),
    }
}

fn section_document(
    course: &TrajectoryRequest,
    section: &PoincareSection,
    (crossings, touches): (&[Crossing], &[f64]),
) -> SectionDocument {
    let [every, rising] = match section {
        PoincareSection::Impacts | PoincareSection::Events => [None, None],
        PoincareSection::Every(period) => [Some(period.to_string()), None],
        PoincareSection::Rising(expression) => [None, Some(expression.to_string())],
    };
    let state = |crossing: &Crossing| MotionSample::new(course, crossing.time, &crossing.state);
    SectionDocument {
        every,
        rising,
        after: course.after,
        states: crossings.iter().map(state).collect(),
        touches: touches.to_vec(),
    }
}

/// Many motions of one equation or mechanism, over every combination of the values of some
/// parameters or starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct MotionSweepDocument {
    /// The kind of document.
    pub schema: String,
    /// The coordinates.
    pub coordinates: Vec<String>,
    /// The equations of motion, each `... = 0`.
    pub equations: Vec<String>,
    /// The value of every parameter that is not varied.
    pub parameters: Map<f64>,
    /// Coordinates and velocities at t = 0, where they are not varied.
    pub start: Map<f64>,
    /// How long each motion is followed.
    pub duration: f64,
    /// From when on extremes and section count.
    pub after: f64,
    /// What is varied; the last varies fastest.
    pub varied: Vec<String>,
    /// The motions, in order.
    pub motions: Vec<SweptMotionDocument>,
    /// The attractors on which motions from many starts settle, that of the most motions first; left out where
    /// anything but a start is varied, or without a section.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attractors: Option<Vec<AttractorDocument>>,
}

/// A motion that repeats itself on a section, on which others settle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "Attractor"))]
pub struct AttractorDocument {
    /// Its states on the section in their order, coordinates and velocities.
    pub states: Vec<Map<f64>>,
    /// The number of motions that settle on it.
    pub motions: usize,
}

/// One of many motions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "SweptMotion"))]
pub struct SweptMotionDocument {
    /// The values of what is varied.
    pub values: Map<f64>,
    /// Those at the end.
    pub final_state: MotionSample,
    /// The least and the greatest value of each coordinate.
    pub extremes: Map<[f64; 2]>,
    /// The states on the section; null where none was asked for.
    pub section: Option<SectionDocument>,
    /// The number of impacts on walls; left out without a wall.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub impacts: Option<usize>,
    /// The number of events; left out without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub events: Option<usize>,
    /// The attractor on which it settles, counted from 0; left out if it settles on none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attractor: Option<usize>,
    /// Why it ends where it does.
    pub stopped: String,
    /// Whether it was followed as long as asked.
    pub complete: bool,
}

/// The document of kind `motion-sweep`.
pub fn motion_sweep(sweep: &MotionSweep) -> MotionSweepDocument {
    let course = sweep.course;
    let is_varied = |name: &str| sweep.names.iter().any(|varied| varied.name() == name);
    let rest = |all: Map<f64>| -> Map<f64> {
        all.into_iter().filter(|(name, _)| !is_varied(name)).collect()
    };
    let basins = sweep.basins();
    let attractor = |index: usize| match basins.as_ref().map(|basins| basins.fates[index]) {
        Some(Fate::Settled(attractor)) => Some(attractor),
        _ => None,
    };
    let motions = sweep.motions.iter().enumerate().map(|(index, motion)| SweptMotionDocument {
        values: named(sweep.names.iter().zip(motion.values.iter().copied())),
        final_state: MotionSample::new(course, motion.end, &motion.state),
        extremes: named(course.coordinates.iter().zip(motion.extremes.iter().copied())),
        section: course
            .section
            .as_ref()
            .map(|section| section_document(course, section, (&motion.crossings, &motion.touches))),
        impacts: (!course.walls.is_empty()).then_some(motion.impacts),
        events: (!course.events.is_empty()).then_some(motion.events),
        attractor: attractor(index),
        stopped: in_words(motion.reason).to_owned(),
        complete: motion.reason == PathEnd::Reached,
    });
    MotionSweepDocument {
        schema: DocumentKind::MotionSweep.schema().to_owned(),
        coordinates: texts(&course.coordinates),
        equations: course.equations.iter().map(|left| format!("{left} = 0")).collect(),
        parameters: rest(named(course.values.iter().map(|(name, value)| (name, *value)))),
        start: rest(states(course, &course.start)),
        duration: course.duration,
        after: course.after,
        varied: texts(sweep.names),
        motions: motions.collect(),
        attractors: basins.as_ref().map(|basins| {
            let of = |attractor: &Attractor| AttractorDocument {
                states: attractor.states.iter().map(|state| states(course, state)).collect(),
                motions: attractor.motions,
            };
            basins.attractors.iter().map(of).collect()
        }),
    }
}

//! Kind `impact`: the three phases of a swing that hits a barrier.

use num_complex::Complex64;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::solution::{SolutionDocument, solution};
use super::{JsonError, Kind, check_kind};
use crate::impact::{self, Deviation, Form, Impact, Rule, ThreePhases};
use crate::verify::Verdict;

/// A pendulum released from rest at x = -amplitude that hits an elastic barrier: approach, contact and return in closed form, beside
/// Runge-Kutta on the original equation. Angles are in radians; time is in units of 1/omega of small swings, sqrt(L/g).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct ImpactDocument {
    /// The kind of document.
    #[schemars(extend("const" = Kind::Impact.schema()))]
    pub schema: String,
    /// The equation of motion that is judged, `... = 0`, its force on the barrier included.
    pub equation: String,
    /// The numbers of the problem.
    pub parameters: Parameters,
    /// The law of the free swing, as a document of its own.
    pub law: SolutionDocument,
    /// omega of approach and return by the law, in radians per unit of time.
    pub frequency: f64,
    /// The three phases as the paper has them: the contact begins with the speed of the cosine, every join is continuous.
    pub phases: Vec<Phase>,
    /// The three phases with the contact speed from the energy: the velocity jumps at both joins by `velocity_jump`.
    pub energy_phases: Vec<Phase>,
    /// The numbers of the contact.
    pub contact: Contact,
    /// The time from the release to the touch, in units of time.
    pub time_to_contact: Quantity,
    /// The time from release to release, in units of time.
    pub period: Quantity,
    /// What Runge-Kutta says of the phases.
    pub verification: Verification,
}

/// The numbers of an impact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Parameters {
    /// The release is from rest at x = -amplitude, in radians.
    pub amplitude: f64,
    /// The place of the barrier, in radians.
    pub barrier: f64,
    /// The dimensionless stiffness of the barrier.
    pub gamma: f64,
    /// Where gamma comes from, in words.
    pub gamma_source: String,
    /// The order of the law in the amplitude.
    pub order: u32,
    /// How the line is fitted that replaces the force of the barrier.
    #[schemars(extend("enum" = Rule::ALL.map(Rule::name)))]
    pub linearisation: String,
    /// The relative error of a step of Runge-Kutta.
    pub integrator_tolerance: f64,
}

/// One phase of the motion. Its clock is s = t - start: the closed form counts its time from the start of the phase.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Phase {
    /// Which phase it is.
    pub name: PhaseName,
    /// The time t since the release at which it begins, in units of time: the zero of its clock.
    pub start: f64,
    /// The time t since the release at which it ends, in units of time.
    pub end: f64,
    /// The state at its start.
    pub start_state: State,
    /// The state at its end.
    pub end_state: State,
    /// The motion as text; its numbers are rounded, those of `coefficients` are not.
    pub closed_form: String,
    /// The numbers of the closed form.
    pub coefficients: Coefficients,
}

/// The name of a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PhaseName {
    /// From the release to the touch.
    Approach,
    /// Barrier and pendulum touch.
    Contact,
    /// From the end of the contact to the turning point.
    Return,
}

/// A state of the pendulum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct State {
    /// The displacement, in radians.
    pub x: f64,
    /// Its rate, in radians per unit of time.
    pub velocity: f64,
}

/// The numbers of a closed form, with the time s = t - start of its phase.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Coefficients {
    /// Contact: x = centre + re cos(frequency s) - im sin(frequency s).
    Oscillation(Oscillation),
    /// Approach and return: x = amplitude cos(frequency s + phase).
    Cosine(Cosine),
}

/// x = centre + re cos(frequency s) - im sin(frequency s), s = t - start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Oscillation {
    /// The point oscillated about, in radians.
    pub centre: f64,
    /// The complex amplitude.
    pub amplitude: Amplitude,
    /// The angular frequency, in radians per unit of time.
    pub frequency: f64,
}

/// A complex amplitude.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Amplitude {
    /// The factor of cos(frequency s), in radians.
    pub re: f64,
    /// The factor of -sin(frequency s), in radians.
    pub im: f64,
}

/// x = amplitude cos(frequency s + phase), s = t - start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Cosine {
    /// The amplitude with its sign, in radians.
    pub amplitude: f64,
    /// The angular frequency, in radians per unit of time.
    pub frequency: f64,
    /// The phase at the start, in radians.
    pub phase: f64,
}

/// The numbers of the contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Contact {
    /// The speed at the touch, in radians per unit of time.
    pub speed: Quantity,
    /// The greatest depth in the barrier, in radians.
    pub penetration: Quantity,
    /// The time from touch to release, in units of time.
    pub duration: Quantity,
}

/// One number by both closed forms and by Runge-Kutta.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Quantity {
    /// By `phases`.
    pub paper: f64,
    /// By `energy_phases`.
    pub energy: f64,
    /// By Runge-Kutta on the original equation.
    pub runge_kutta: f64,
    /// paper / runge_kutta - 1, as a fraction.
    pub paper_error: f64,
    /// energy / runge_kutta - 1, as a fraction.
    pub energy_error: f64,
}

/// The closed forms beside the true motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields, rename = "ImpactVerification")]
pub struct Verification {
    /// The size of the relative error up to which a verdict is `pass`.
    pub tolerance: f64,
    /// How well Runge-Kutta keeps the energy, as a fraction of the kinetic energy at the touch.
    pub energy_drift: f64,
    /// What is said of `phases`.
    pub paper: Column,
    /// What is said of `energy_phases`.
    pub energy: Column,
    /// The verdict on `phases`.
    #[schemars(extend("enum" = [Verdict::Pass.name(), Verdict::Fail.name()]))]
    pub verdict: String,
}

/// The judgement of three phases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Column {
    /// The jump of the velocity at either end of the contact, in radians per unit of time.
    pub velocity_jump: f64,
    /// The line that replaces the force of the barrier.
    pub line: Line,
    /// The largest |x - x_true| over the period, as a fraction of the amplitude.
    pub max_deviation: f64,
    /// The same in approach, contact and return.
    pub max_deviation_by_phase: [f64; 3],
    /// Whether every quantity is within the tolerance.
    #[schemars(extend("enum" = [Verdict::Pass.name(), Verdict::Fail.name()]))]
    pub verdict: String,
}

/// The line slope * x + constant that replaces (x - barrier)^(3/2), per unit of gamma.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Line {
    /// The slope.
    pub slope: f64,
    /// The value at x = 0.
    pub constant: f64,
}

/// The document of kind `impact`.
///
/// ```
/// use lindstedt::impact::{Setup, solve};
///
/// let impact = solve(Setup { stiffness: 1e6, ..Setup::default() })?;
/// let document = lindstedt::export::json::impact(&impact, 0.01);
/// assert_eq!((document.phases.len(), document.frequency), (3, impact.frequency()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn impact(impact: &Impact, tolerance: f64) -> ImpactDocument {
    let setup = &impact.setup;
    let [time_to_contact, speed, penetration, duration, period] = impact.quantities().map(quantity);
    let column = |phases: &ThreePhases, deviation: &Deviation| Column {
        velocity_jump: phases.velocity_jump,
        line: Line {
            slope: phases.line.slope,
            constant: -phases.line.q(setup.barrier),
        },
        max_deviation: deviation.total / setup.amplitude,
        max_deviation_by_phase: deviation.phases.map(|largest| largest / setup.amplitude),
        verdict: impact.verdict(phases.column, tolerance).name().to_owned(),
    };
    ImpactDocument {
        schema: Kind::Impact.schema().to_owned(),
        equation: impact.equation.clone(),
        parameters: Parameters {
            amplitude: setup.amplitude,
            barrier: setup.barrier,
            gamma: setup.stiffness,
            gamma_source: setup.stiffness_source.clone(),
            order: setup.order,
            linearisation: setup.rule.name().to_owned(),
            integrator_tolerance: setup.integrator_tolerance,
        },
        law: solution(&impact.free_swing, None),
        frequency: impact.frequency(),
        phases: impact.paper.phases.iter().map(Phase::of).collect(),
        energy_phases: impact.energy.phases.iter().map(Phase::of).collect(),
        contact: Contact {
            speed,
            penetration,
            duration,
        },
        time_to_contact,
        period,
        verification: Verification {
            tolerance,
            energy_drift: impact.truth.energy_drift,
            paper: column(&impact.paper, &impact.paper_deviation),
            energy: column(&impact.energy, &impact.energy_deviation),
            verdict: impact.verdict(impact::ContactSpeed::Paper, tolerance).name().to_owned(),
        },
    }
}

fn quantity(quantity: impact::Quantity) -> Quantity {
    Quantity {
        paper: quantity.paper,
        energy: quantity.energy,
        runge_kutta: quantity.runge_kutta,
        paper_error: quantity.paper_error(),
        energy_error: quantity.energy_error(),
    }
}

impl PhaseName {
    /// The name as the closed forms have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Approach => "approach",
            Self::Contact => "contact",
            Self::Return => "return",
        }
    }
}

impl Phase {
    fn of(phase: &impact::Phase) -> Self {
        let state = |elapsed: f64| {
            let (x, velocity) = phase.form.at(elapsed);
            State { x, velocity }
        };
        Self {
            name: match phase.name {
                "approach" => PhaseName::Approach,
                "contact" => PhaseName::Contact,
                _ => PhaseName::Return,
            },
            start: phase.start,
            end: phase.end,
            start_state: state(0.0),
            end_state: state(phase.end - phase.start),
            closed_form: phase.closed_form(),
            coefficients: match phase.form {
                Form::Cosine {
                    amplitude,
                    frequency,
                    phase,
                } => Coefficients::Cosine(Cosine {
                    amplitude,
                    frequency,
                    phase,
                }),
                Form::Oscillation {
                    centre,
                    amplitude: Complex64 { re, im },
                    frequency,
                } => Coefficients::Oscillation(Oscillation {
                    centre,
                    amplitude: Amplitude { re, im },
                    frequency,
                }),
            },
        }
    }

    /// The phase that the document describes.
    pub fn read(&self) -> impact::Phase {
        impact::Phase {
            name: self.name.name(),
            start: self.start,
            end: self.end,
            form: match &self.coefficients {
                Coefficients::Cosine(cosine) => Form::Cosine {
                    amplitude: cosine.amplitude,
                    frequency: cosine.frequency,
                    phase: cosine.phase,
                },
                Coefficients::Oscillation(oscillation) => Form::Oscillation {
                    centre: oscillation.centre,
                    amplitude: Complex64::new(oscillation.amplitude.re, oscillation.amplitude.im),
                    frequency: oscillation.frequency,
                },
            },
        }
    }
}

impl ImpactDocument {
    /// The three phases of the paper's column.
    ///
    /// # Errors
    /// A document of another kind.
    pub fn read_phases(&self) -> Result<Vec<impact::Phase>, JsonError> {
        check_kind(&self.schema, Kind::Impact)?;
        Ok(self.phases.iter().map(Phase::read).collect())
    }
}

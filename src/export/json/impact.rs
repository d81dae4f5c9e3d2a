//! Kind `impact`: the three phases of a swing that hits a barrier.

use std::collections::BTreeMap;

use num_complex::Complex64;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::solution::{SolutionDocument, solution};
use super::{JsonError, Kind, check_kind};
use crate::impact::contact::SineSeries;
use crate::impact::{self, Form, Impact, Reading, Rule, Setup, Side};
use crate::verify::Verdict;

/// A swing released from rest that hits an elastic barrier: approach, contact and return in closed form, beside Runge-Kutta on the
/// original equation. For the pendulum angles are in radians and time is in units of 1/omega of small swings, sqrt(L/g); for an equation
/// of the user's both have its units.
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
    /// The law of the free swing in the paper's reading, as a document of its own; null where that reading does not apply.
    pub law: Option<SolutionDocument>,
    /// omega of approach and return by that law, in radians per unit of time.
    pub frequency: Option<f64>,
    /// The law of the derived phases, as a document of its own; null where there are none.
    pub derived_law: Option<DerivedLaw>,
    /// The three phases as the paper has them: the contact begins with the speed of the cosine, every join is continuous.
    pub phases: Vec<Phase>,
    /// The three phases with the contact speed from the energy: the velocity jumps at both joins by `velocity_jump`.
    pub energy_phases: Vec<Phase>,
    /// The three phases with every harmonic of a derived motion, all joins from it; empty where no method gives one.
    pub derived_phases: Vec<Phase>,
    /// The numbers of the contact.
    pub contact: Contact,
    /// The time from the release to the touch, in units of time.
    pub time_to_contact: Quantity,
    /// The time from release to release, in units of time.
    pub period: Quantity,
    /// What Runge-Kutta says of the phases.
    pub verification: Verification,
}

/// The law of the derived phases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct DerivedLaw {
    /// The answer of the method; where `sign` is -1 it is that of the equation of -x.
    pub law: SolutionDocument,
    /// The value of its amplitude symbol.
    pub amplitude: f64,
    /// 1, or -1: x is sign times the displacement of `law`.
    pub sign: f64,
    /// omega, in radians per unit of time.
    pub frequency: f64,
}

/// The numbers of an impact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Parameters {
    /// The distance of the turning point from the equilibrium, in radians.
    pub amplitude: f64,
    /// The place of the release, from rest, in radians.
    pub release: f64,
    /// Where the cycle starts, in radians: the release, or the turning point of a motion released inside the barrier.
    pub turning_point: f64,
    /// The place of the barrier, in radians.
    pub barrier: f64,
    /// On which side of its place the barrier is.
    #[schemars(extend("enum" = ["left", "right"]))]
    pub side: String,
    /// The force of the barrier as an expression in the depth; null for that of Hertz, gamma*d^(3/2).
    pub force: Option<String>,
    /// The values of the other parameters of the equation.
    pub values: BTreeMap<String, f64>,
    /// The dimensionless stiffness of the barrier.
    pub gamma: f64,
    /// Where gamma comes from, in words.
    pub gamma_source: String,
    /// The order of `law` in the amplitude; null where there is none.
    pub order: Option<u32>,
    /// How the line is fitted that replaces the force of the barrier.
    #[schemars(extend("enum" = Rule::ALL.map(Rule::name)))]
    pub linearisation: String,
    /// The relative error of a step of Runge-Kutta.
    pub integrator_tolerance: f64,
}

/// One phase of the motion. Its closed form counts the time s = t - clock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Phase {
    /// Which phase it is.
    pub name: PhaseName,
    /// The time t since the release at which it begins, in units of time.
    pub start: f64,
    /// The time t since the release at which it ends, in units of time.
    pub end: f64,
    /// The time t since the release from which its closed form counts, in units of time: its start, or the end of a derived return.
    pub clock: f64,
    /// The state at its start.
    pub start_state: State,
    /// The state at its end.
    pub end_state: State,
    /// The motion as text; its numbers are rounded, those of `coefficients` are not.
    pub closed_form: String,
    /// The numbers of the closed form; null in derived phases, which have more than one wave.
    pub coefficients: Option<Coefficients>,
    /// The same motion as a sum of harmonics, whatever its form.
    pub displacement: Displacement,
}

/// x = centre + parabola * s * (duration - s) + the sum of cos * cos(harmonic * frequency * s) + sin * sin(harmonic * frequency * s),
/// with s = t - clock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields, rename = "PhaseDisplacement")]
pub struct Displacement {
    /// What does not oscillate, in radians.
    pub centre: f64,
    /// What the force at the touch bends the motion by: zero in flight, in radians per unit of time squared.
    pub parabola: f64,
    /// The angular frequency of the first harmonic, in radians per unit of time.
    pub frequency: f64,
    /// How long the phase lasts, in units of time: `end` less `start`, with all digits also where it is short.
    pub duration: f64,
    /// The harmonics.
    pub harmonics: Vec<Harmonic>,
}

/// A harmonic of a phase, in numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields, rename = "PhaseHarmonic")]
pub struct Harmonic {
    /// Its number.
    pub harmonic: u32,
    /// The factor of the cosine, in radians.
    pub cos: f64,
    /// The factor of the sine, in radians.
    pub sin: f64,
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

/// The numbers of a closed form of one wave, with the time s = t - start of its phase.
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

/// One number by each closed form and by Runge-Kutta; null for a reading that does not apply.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Quantity {
    /// By `phases`.
    pub paper: Option<f64>,
    /// By `energy_phases`.
    pub energy: Option<f64>,
    /// By `derived_phases`.
    pub derived: Option<f64>,
    /// By Runge-Kutta on the original equation.
    pub runge_kutta: f64,
    /// paper / runge_kutta - 1, as a fraction.
    pub paper_error: Option<f64>,
    /// energy / runge_kutta - 1, as a fraction.
    pub energy_error: Option<f64>,
    /// derived / runge_kutta - 1, as a fraction.
    pub derived_error: Option<f64>,
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
    pub paper: Option<Column>,
    /// What is said of `energy_phases`.
    pub energy: Option<Column>,
    /// What is said of `derived_phases`.
    pub derived: Option<Column>,
    /// The verdict on `phases`; where the paper's reading does not apply, on `derived_phases`.
    #[schemars(extend("enum" = [Verdict::Pass.name(), Verdict::Fail.name()]))]
    pub verdict: String,
}

/// The judgement of three phases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Column {
    /// The jump of the velocity at either end of the contact, in radians per unit of time.
    pub velocity_jump: f64,
    /// The line that replaces the force of the barrier; null in the derived reading, which has none.
    pub line: Option<Line>,
    /// The largest |x - x_true| over the period, as a fraction of the amplitude.
    pub max_deviation: f64,
    /// The same in approach, contact and return.
    pub max_deviation_by_phase: [f64; 3],
    /// The same with the clock of each phase set right: of the flights as a fraction of the amplitude, of the contact as one of the
    /// true depth.
    pub max_deviation_of_shape: [f64; 3],
    /// Whether every quantity and every phase on its own clock is within the tolerance.
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
    let [time_to_contact, speed, penetration, duration, period] =
        impact.quantities().map(|found| quantity(impact, &found));
    let verdicts = impact.verdicts(tolerance);
    let judged = |reading| {
        let index = impact.columns.iter().position(|column| column.reading == reading)?;
        let (column, verdict) = (&impact.columns[index], verdicts[index]);
        let line = column.phases.fitted.map(|fitted| Line {
            slope: fitted.line.slope,
            constant: -fitted.line.q(setup.barrier),
        });
        Some(Column {
            velocity_jump: column.phases.velocity_jump,
            line,
            max_deviation: column.deviation.total / impact.amplitude(),
            max_deviation_by_phase: column.deviation.phases.map(|largest| largest / impact.amplitude()),
            max_deviation_of_shape: impact.deviations(column),
            verdict: verdict.name().to_owned(),
        })
    };
    let phases = |reading| {
        let column = impact.column(reading).into_iter();
        column.flat_map(|column| &column.phases.phases).map(Phase::of).collect()
    };
    let [paper, energy, derived] = READINGS.map(judged);
    let first = paper.as_ref().or(derived.as_ref()).map(|column| column.verdict.clone());
    ImpactDocument {
        schema: Kind::Impact.schema().to_owned(),
        equation: impact.equation.clone(),
        parameters: Parameters::of(
            setup,
            [impact.equilibrium, impact.turning_point],
            impact.free_swing.as_ref().map(|law| law.order),
        ),
        law: impact.free_swing.as_ref().map(|law| solution(law, None)),
        frequency: impact.frequency(),
        derived_law: impact.flight.as_ref().map(|flight| DerivedLaw {
            law: solution(&flight.solution, None),
            amplitude: flight.amplitude,
            sign: flight.sign,
            frequency: flight.motion.frequency(),
        }),
        phases: phases(Reading::Paper),
        energy_phases: phases(Reading::Energy),
        derived_phases: phases(Reading::Derived),
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
            paper,
            energy,
            derived,
            verdict: first.unwrap_or_else(|| Verdict::Fail.name().to_owned()),
        },
    }
}

impl Parameters {
    /// The numbers of a setup whose swing has this equilibrium and turns at this point, and the order of `law`.
    pub(super) fn of(setup: &Setup, [equilibrium, turning_point]: [f64; 2], order: Option<u32>) -> Self {
        Self {
            amplitude: (turning_point - equilibrium).abs(),
            release: setup.release,
            turning_point,
            barrier: setup.barrier,
            side: match setup.side {
                Side::Left => "left",
                Side::Right => "right",
            }
            .to_owned(),
            force: setup.force.as_ref().map(ToString::to_string),
            values: setup
                .values
                .numbers()
                .into_iter()
                .map(|(name, value)| (name.name().to_owned(), value))
                .collect(),
            gamma: setup.stiffness,
            gamma_source: setup.stiffness_source.clone(),
            order,
            linearisation: setup.rule.name().to_owned(),
            integrator_tolerance: setup.integrator_tolerance,
        }
    }
}

const READINGS: [Reading; 3] = [Reading::Paper, Reading::Energy, Reading::Derived];

fn quantity(impact: &Impact, quantity: &impact::Quantity) -> Quantity {
    let errors: Vec<f64> = quantity.errors().collect();
    let found = |reading| {
        let index = impact.columns.iter().position(|column| column.reading == reading);
        match index {
            Some(index) => (Some(quantity.closed_forms[index]), Some(errors[index])),
            None => (None, None),
        }
    };
    let [(paper, paper_error), (energy, energy_error), (derived, derived_error)] = READINGS.map(found);
    Quantity {
        paper,
        energy,
        derived,
        runge_kutta: quantity.runge_kutta,
        paper_error,
        energy_error,
        derived_error,
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
        let state = |time: f64| {
            let (x, velocity) = phase.at(time);
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
            clock: phase.clock,
            start_state: state(phase.start),
            end_state: state(phase.end),
            closed_form: phase.closed_form(),
            coefficients: match phase.form {
                Form::Cosine {
                    amplitude,
                    frequency,
                    phase,
                } => Some(Coefficients::Cosine(Cosine {
                    amplitude,
                    frequency,
                    phase,
                })),
                Form::Oscillation {
                    centre,
                    amplitude: Complex64 { re, im },
                    frequency,
                } => Some(Coefficients::Oscillation(Oscillation {
                    centre,
                    amplitude: Amplitude { re, im },
                    frequency,
                })),
                Form::Harmonics { .. } | Form::Contact { .. } => None,
            },
            displacement: Displacement {
                centre: phase.form.centre(),
                parabola: phase.form.parabola(),
                frequency: phase.form.frequency(),
                duration: match &phase.form {
                    Form::Contact { depth, .. } => depth.duration,
                    _ => phase.end - phase.start,
                },
                harmonics: phase
                    .form
                    .harmonics()
                    .into_iter()
                    .map(|(harmonic, Complex64 { re, im })| Harmonic {
                        harmonic,
                        cos: re,
                        sin: -im,
                    })
                    .collect(),
            },
        }
    }

    /// The phase that the document describes.
    pub fn read(&self) -> impact::Phase {
        impact::Phase {
            name: self.name.name(),
            start: self.start,
            end: self.end,
            clock: self.clock,
            form: match &self.coefficients {
                Some(Coefficients::Cosine(cosine)) => Form::Cosine {
                    amplitude: cosine.amplitude,
                    frequency: cosine.frequency,
                    phase: cosine.phase,
                },
                Some(Coefficients::Oscillation(oscillation)) => Form::Oscillation {
                    centre: oscillation.centre,
                    amplitude: Complex64::new(oscillation.amplitude.re, oscillation.amplitude.im),
                    frequency: oscillation.frequency,
                },
                None if self.name == PhaseName::Contact => Form::Contact {
                    barrier: self.displacement.centre,
                    inward: 1.0,
                    depth: SineSeries::new(
                        self.displacement.duration,
                        self.displacement.parabola,
                        self.displacement.harmonics.iter().map(|wave| wave.sin).collect(),
                    ),
                },
                None => Form::Harmonics {
                    centre: self.displacement.centre,
                    frequency: self.displacement.frequency,
                    harmonics: self
                        .displacement
                        .harmonics
                        .iter()
                        .map(|wave| (wave.harmonic, Complex64::new(wave.cos, -wave.sin)))
                        .collect(),
                },
            },
        }
    }
}

impl ImpactDocument {
    /// The three phases of the paper's reading; where that does not apply, the derived ones.
    ///
    /// # Errors
    /// A document of another kind.
    pub fn read_phases(&self) -> Result<Vec<impact::Phase>, JsonError> {
        check_kind(&self.schema, Kind::Impact)?;
        let phases = match self.phases.is_empty() {
            false => &self.phases,
            true => &self.derived_phases,
        };
        Ok(phases.iter().map(Phase::read).collect())
    }
}

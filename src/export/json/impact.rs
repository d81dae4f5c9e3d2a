//! Kind `impact`: the three phases of a swing that hits a barrier.

use std::collections::BTreeMap;

use num_complex::Complex64;
#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number::text;
use super::solution::{SolutionDocument, solution};
use super::{DocumentKind, JsonError, check_kind};
use crate::audit::paper;
#[cfg(feature = "schema")]
use crate::impact::Rule;
use crate::impact::contact::{ContactErrors, ContactMotion, ContactRow, LossyContact, SineSeries};
#[cfg(feature = "schema")]
use crate::impact::contact::{ContactLaw, LossyLaw};
use crate::impact::{
    self, DerivedContact, Form, Impact, LossAmount, LossyRow, Modulus, PhaseReading, Setup,
    SiImpact, Side,
};
use crate::verify::Verdict;

/// A swing released from rest that hits an elastic barrier: approach, contact and return in closed
/// form, beside Runge-Kutta on the original equation. For the pendulum angles are in radians and
/// time is in units of 1/omega of small swings, sqrt(L/g); for an equation of the user's both have
/// its units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ImpactDocument {
    /// The kind of document.
    pub schema: String,
    /// The equation of motion that is judged, `... = 0`, its force on the barrier included.
    pub equation: String,
    /// The numbers of the problem.
    pub parameters: Parameters,
    /// The law of the free swing in the paper's reading, as a document of its own; null where that
    /// reading does not apply.
    pub law: Option<SolutionDocument>,
    /// omega of approach and return by that law, in radians per unit of time.
    pub frequency: Option<f64>,
    /// The law of the derived phases, as a document of its own; null where there are none.
    pub derived_law: Option<DerivedLaw>,
    /// The three phases as the paper has them: the contact begins with the speed of the cosine,
    /// every join is continuous.
    pub phases: Vec<Phase>,
    /// The three phases with the contact speed from the energy: the velocity jumps at both joins by
    /// `velocity_jump`.
    pub energy_phases: Vec<Phase>,
    /// The three phases with every harmonic of a derived motion, all joins from it; empty where no
    /// method gives one.
    pub derived_phases: Vec<Phase>,
    /// The numbers of the contact.
    pub contact: Contact,
    /// What the contact loses; null where it loses nothing.
    pub contact_damping: Option<ContactDamping>,
    /// Every law of the contact at the speed of the touch by the energy; null where they are not
    /// asked for.
    pub contact_laws: Option<Vec<ContactLawRow>>,
    /// Every law of a contact that loses energy, for one restitution at the speed of the touch by the energy; absent
    /// where they are not asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lossy_laws: Vec<LossyLawRow>,
    /// The time from the release to the touch, in units of time.
    pub time_to_contact: Quantity,
    /// The time from release to release, in units of time; where the contact loses energy, to the
    /// turning point after it.
    pub period: Quantity,
    /// What Runge-Kutta says of the phases.
    pub verification: ImpactVerification,
    /// The same quantities in SI units: of the pendulum with the contact of Hertz, where gamma
    /// follows from the design or mass, length and gravity are given; null elsewhere, and where a
    /// number would be beyond the range of floating point.
    pub si: Option<Si>,
}

/// The numbers of an impact in SI units: m L^2 x'' + m g L sin x + k L (L (x - x_c))^(3/2) = 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Si {
    /// The mass m, in kg.
    pub mass: f64,
    /// The length L, in m.
    pub length: f64,
    /// The acceleration of gravity g, in m/s^2.
    pub gravity: f64,
    /// The radius R of the sphere, in m; null where gamma is given and it is not.
    pub radius: Option<f64>,
    /// The modulus E of the contact, in Pa; null where gamma is given.
    pub modulus: Option<f64>,
    /// Whose modulus that is: `barrier` alone as in the paper, `rigid-sphere` for E1/(1 - nu1^2),
    /// or `both`; null where gamma is given.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["barrier", "rigid-sphere", "both", null])))]
    pub modulus_of: Option<String>,
    /// The stiffness k of the contact, in N/m^(3/2): gamma m g / L^(3/2).
    pub contact_stiffness: f64,
    /// The unit of time sqrt(L/g), in s.
    pub time_unit: f64,
    /// The unit of speed sqrt(g L), in m/s.
    pub speed_unit: f64,
    /// The unit of force m g, in N.
    pub force_unit: f64,
    /// The unit of energy m g L, in J.
    pub energy_unit: f64,
    /// The time from the release to the touch, in s.
    pub time_to_contact: Quantity,
    /// The speed at the touch, in m/s.
    pub speed: Quantity,
    /// The kinetic energy at the touch, in J.
    pub energy: Quantity,
    /// The greatest depth in the barrier, in m.
    pub penetration: Quantity,
    /// The time from touch to release, in s.
    pub duration: Quantity,
    /// The time from release to release, in s.
    pub period: Quantity,
    /// The greatest force of the contact, that of the damping included, in N; without damping it is
    /// that at the greatest depth.
    pub peak_force: Quantity,
    /// The pressure in the middle of the contact at the greatest depth, in Pa; null without a
    /// radius.
    pub peak_pressure: Option<Quantity>,
    /// The contact time that the paper prints, beside that of every reading.
    pub printed_contact_time: PrintedContactTime,
    /// The yield limits that are stated, beside the peak pressure of Runge-Kutta.
    pub yield_limits: Vec<YieldLimit>,
}

/// The contact time that the paper prints, compared with and never computed from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct PrintedContactTime {
    /// As printed, in s.
    pub value: f64,
    /// By Runge-Kutta.
    pub runge_kutta: OverPrinted,
    /// By `phases`; null where the paper's reading does not apply.
    pub paper: Option<OverPrinted>,
    /// By `energy_phases`; null likewise.
    pub energy: Option<OverPrinted>,
    /// By `derived_phases`; null where there are none.
    pub derived: Option<OverPrinted>,
}

/// A contact time over the printed one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct OverPrinted {
    /// The contact time of this reading over the printed one.
    pub ratio: f64,
    /// Whether that is one within the tolerance.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["reproduced", "not-reproduced"])))]
    pub verdict: String,
}

/// A yield limit that is stated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct YieldLimit {
    /// Whose it is.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["sphere", "barrier"])))]
    pub body: String,
    /// The limit Y, in Pa.
    pub limit: f64,
    /// The peak pressure at which the body begins to yield, 1.6 Y, in Pa.
    pub onset: f64,
    /// Whether the peak pressure of Runge-Kutta is above that: then the theory is outside its
    /// range.
    pub exceeded: bool,
}

/// The law of the derived phases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Parameters {
    /// The distance of the turning point from the equilibrium, in radians.
    pub amplitude: f64,
    /// The place of the release, from rest, in radians.
    pub release: f64,
    /// Where the cycle starts, in radians: the release, or the turning point of a motion released
    /// inside the barrier.
    pub turning_point: f64,
    /// The place of the barrier, in radians.
    pub barrier: f64,
    /// On which side of its place the barrier is.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["left", "right"])))]
    pub side: String,
    /// The force of the barrier as an expression in the depth; null for that of Hertz,
    /// gamma*d^(3/2).
    pub force: Option<String>,
    /// The values of the other parameters of the equation.
    pub values: BTreeMap<String, f64>,
    /// The dimensionless stiffness of the barrier.
    pub gamma: f64,
    /// Where gamma comes from, in words.
    pub gamma_source: String,
    /// The order of `law` in the amplitude; null where there is none.
    pub order: Option<u32>,
    /// The law of the contact in the derived phases.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = law_names())))]
    pub contact_law: String,
    /// The damping lambda of the contact, in units of time per radian by Hunt and Crossley, of time with a dashpot; null
    /// where it loses nothing.
    pub lambda: Option<f64>,
    /// The coefficient of restitution that lambda follows from; null where it does not.
    pub restitution: Option<f64>,
    /// How the line is fitted that replaces the force of the barrier.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = Rule::ALL.map(Rule::name))))]
    pub linearisation: String,
    /// The relative error of a step of Runge-Kutta.
    pub integrator_tolerance: f64,
}

/// One phase of the motion. Its closed form counts the time s = t - clock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Phase {
    /// Which phase it is.
    pub name: PhaseName,
    /// The time t since the release at which it begins, in units of time.
    pub start: f64,
    /// The time t since the release at which it ends, in units of time.
    pub end: f64,
    /// The time t since the release from which its closed form counts, in units of time: its start,
    /// or the end of a derived return.
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
    pub displacement: PhaseDisplacement,
}

/// x = centre + parabola * s * (duration - s) + the sum of cos * cos(harmonic * frequency * s) +
/// sin * sin(harmonic * frequency * s), with s = t - clock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct PhaseDisplacement {
    /// What does not oscillate, in radians.
    pub centre: f64,
    /// What the force at the touch bends the motion by: zero in flight, in radians per unit of time
    /// squared.
    pub parabola: f64,
    /// The angular frequency of the first harmonic, in radians per unit of time.
    pub frequency: f64,
    /// How long the phase lasts, in units of time: `end` less `start`, with all digits also where
    /// it is short.
    pub duration: f64,
    /// The harmonics.
    pub harmonics: Vec<PhaseHarmonic>,
}

/// A harmonic of a phase, in numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct PhaseHarmonic {
    /// Its number.
    pub harmonic: u32,
    /// The factor of the cosine, in radians.
    pub cos: f64,
    /// The factor of the sine, in radians.
    pub sin: f64,
}

/// The name of a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct State {
    /// The displacement, in radians.
    pub x: f64,
    /// Its rate, in radians per unit of time.
    pub velocity: f64,
}

/// The numbers of a closed form of one wave, with the time s = t - start of its phase.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(untagged)]
pub enum Coefficients {
    /// Contact: x = centre + re cos(frequency s) - im sin(frequency s).
    Oscillation(Oscillation),
    /// Approach and return: x = amplitude cos(frequency s + phase).
    Cosine(Cosine),
}

/// x = centre + re cos(frequency s) - im sin(frequency s), s = t - start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Oscillation {
    /// The point oscillated about, in radians.
    pub centre: f64,
    /// The complex amplitude.
    pub amplitude: Amplitude,
    /// The angular frequency, in radians per unit of time.
    pub frequency: f64,
}

/// A complex amplitude.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Amplitude {
    /// The factor of cos(frequency s), in radians.
    pub re: f64,
    /// The factor of -sin(frequency s), in radians.
    pub im: f64,
}

/// x = amplitude cos(frequency s + phase), s = t - start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Cosine {
    /// The amplitude with its sign, in radians.
    pub amplitude: f64,
    /// The angular frequency, in radians per unit of time.
    pub frequency: f64,
    /// The phase at the start, in radians.
    pub phase: f64,
}

/// The numbers of the contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Contact {
    /// The speed at the touch, in radians per unit of time.
    pub speed: Quantity,
    /// The greatest depth in the barrier, in radians.
    pub penetration: Quantity,
    /// The time from touch to release, in units of time.
    pub duration: Quantity,
}

/// A number and its error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Judged {
    /// The number.
    pub value: f64,
    /// value / true value - 1, as a fraction.
    pub error: f64,
}

/// A contact that loses energy: its force is gamma F(d) (1 + lambda d') by Hunt and Crossley, gamma (d + lambda d') of a spring
/// with a dashpot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ContactDamping {
    /// The damping, in units of time per radian, of a dashpot in those of time.
    pub lambda: f64,
    /// The speed out over the speed in.
    pub restitution: Quantity,
    /// The speed at the end of the contact, in radians per unit of time.
    pub exit_speed: Quantity,
    /// The energy lost, per unit of mass, in radians squared per unit of time squared.
    pub energy_lost: Quantity,
    /// The greatest force of the derived contact, per unit of mass; null where there are no derived
    /// phases.
    pub peak_force: Option<f64>,
    /// The restitution 1 - (2/3) lambda v of small damping, good to 1 % where lambda v, with v the
    /// speed at the touch, is below 0.15; null where there are no derived phases, and with a dashpot.
    pub small_damping: Option<Judged>,
}

/// One law of the contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ContactLawRow {
    /// Its name, as in a problem file.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ContactLaw::ALL.map(ContactLaw::name))))]
    pub law: String,
    /// Whether it applies.
    pub applies: bool,
    /// Why it does not, in words; null where it does.
    pub reason: Option<String>,
    /// The time from touch to release, in units of time, its error from the exact law; this and the
    /// rest is null where the law does not apply.
    pub duration: Option<Judged>,
    /// The greatest depth, in radians.
    pub penetration: Option<Judged>,
    /// The whole force at that depth, per unit of mass, in radians per unit of time squared.
    pub peak_force: Option<Judged>,
    /// The largest difference of depth at the same time since the touch, as a fraction of the
    /// greatest depth.
    pub max_deviation: Option<f64>,
}

/// One law of a contact that loses energy, in closed form without the force of the swing, beside Runge-Kutta with it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct LossyLawRow {
    /// Its name, as in a problem file.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = LossyLaw::ALL.map(LossyLaw::name))))]
    pub law: String,
    /// The stiffness: the force per unit of mass at depth one at rest; of a spring with a dashpot that of equal
    /// energy at the greatest depth of the barrier without loss.
    pub stiffness: f64,
    /// The damping lambda, time per unit of depth; of a dashpot in units of time.
    pub lambda: f64,
    /// The time from touch to release, in units of time.
    pub duration: Judged,
    /// The greatest depth.
    pub penetration: Judged,
    /// The greatest force of the contact, per unit of mass.
    pub peak_force: Judged,
    /// The speed after the contact over that before.
    pub restitution: Judged,
}

impl LossyLawRow {
    fn from_row(row: &LossyRow) -> Self {
        let errors = row.errors();
        let [duration, penetration, peak_force, restitution] = std::array::from_fn(|index| {
            Judged { value: row.closed_form[index], error: errors[index] }
        });
        Self {
            law: row.law.name().to_owned(),
            stiffness: row.stiffness,
            lambda: row.damping,
            duration,
            penetration,
            peak_force,
            restitution,
        }
    }
}

/// One number by each closed form and by Runge-Kutta; null for a reading that does not apply.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ImpactVerification {
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
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [Verdict::Pass.name(), Verdict::Fail.name()])))]
    pub verdict: String,
}

/// The judgement of three phases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Column {
    /// The jump of the velocity at either end of the contact, in radians per unit of time.
    pub velocity_jump: f64,
    /// The line that replaces the force of the barrier; null in the derived reading, which has
    /// none.
    pub line: Option<Line>,
    /// The largest |x - x_true| over the period, as a fraction of the amplitude.
    pub max_deviation: f64,
    /// The same in approach, contact and return.
    pub max_deviation_by_phase: [f64; 3],
    /// The same with the clock of each phase set right: of the flights as a fraction of the
    /// amplitude, of the contact as one of the true depth.
    pub max_deviation_of_shape: [f64; 3],
    /// Whether every quantity and every phase on its own clock is within the tolerance.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [Verdict::Pass.name(), Verdict::Fail.name()])))]
    pub verdict: String,
}

/// The line slope * x + constant that replaces (x - barrier)^(3/2), per unit of gamma.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
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
            max_deviation_by_phase: column
                .deviation
                .phases
                .map(|largest| largest / impact.amplitude()),
            max_deviation_of_shape: impact.deviations(column),
            verdict: verdict.name().to_owned(),
        })
    };
    let phases = |reading| {
        let column = impact.column(reading).into_iter();
        column.flat_map(|column| &column.phases.phases).map(Phase::from_phase).collect()
    };
    let [paper, energy, derived] = READINGS.map(judged);
    let contact_laws = impact.contact_laws.iter().map(ContactLawRow::from_row);
    let first = paper.as_ref().or(derived.as_ref()).map(|column| column.verdict.clone());
    ImpactDocument {
        schema: DocumentKind::Impact.schema().to_owned(),
        equation: impact.equation.clone(),
        parameters: Parameters::new(
            setup,
            [impact.equilibrium, impact.turning_point],
            impact.free_swing.as_ref().map(|law| law.order),
            impact.damping,
        ),
        law: impact.free_swing.as_ref().map(|law| solution(law, None)),
        frequency: impact.frequency(),
        derived_law: impact.flight.as_ref().map(|flight| DerivedLaw {
            law: solution(&flight.solution, None),
            amplitude: flight.amplitude,
            sign: flight.sign,
            frequency: flight.motion.frequency(),
        }),
        phases: phases(PhaseReading::Paper),
        energy_phases: phases(PhaseReading::Energy),
        derived_phases: phases(PhaseReading::Derived),
        contact: Contact { speed, penetration, duration },
        contact_damping: contact_damping(impact),
        contact_laws: (impact.setup.every_contact_law && impact.setup.loss.is_none())
            .then(|| contact_laws.collect()),
        lossy_laws: impact.lossy_laws.iter().map(LossyLawRow::from_row).collect(),
        time_to_contact,
        period,
        verification: ImpactVerification {
            tolerance,
            energy_drift: impact.truth.energy_drift,
            paper,
            energy,
            derived,
            verdict: first.unwrap_or_else(|| Verdict::Fail.name().to_owned()),
        },
        si: impact.si().map(|found| si(impact, &found, tolerance)),
    }
}

/// The numbers in SI units.
fn si(impact: &Impact, si: &SiImpact, tolerance: f64) -> Si {
    let units = &si.units;
    let of = |found| quantity(impact, found);
    let over_printed = |ratio: f64| OverPrinted {
        ratio,
        verdict: match paper::is_reproduced(ratio, tolerance) {
            true => "reproduced",
            false => "not-reproduced",
        }
        .to_owned(),
    };
    let over_the_printed = paper::over_contact_time(si);
    let over = of(&over_the_printed);
    Si {
        mass: units.mass,
        length: units.length,
        gravity: units.gravity,
        radius: units.radius,
        modulus: units.modulus.map(Modulus::value),
        modulus_of: units.modulus.map(|modulus| {
            match modulus {
                Modulus::BarrierAlone(_) => "barrier",
                Modulus::RigidSphere(_) => "rigid-sphere",
                Modulus::Both { .. } => "both",
            }
            .to_owned()
        }),
        contact_stiffness: si.contact_stiffness,
        time_unit: units.time(),
        speed_unit: units.speed(),
        force_unit: units.force(),
        energy_unit: units.energy(),
        time_to_contact: of(&si.time_to_contact),
        speed: of(&si.speed),
        energy: of(&si.energy),
        penetration: of(&si.penetration),
        duration: of(&si.duration),
        period: of(&si.period),
        peak_force: of(&si.peak_force),
        peak_pressure: si.peak_pressure.as_ref().map(of),
        printed_contact_time: PrintedContactTime {
            value: paper::CONTACT_TIME,
            runge_kutta: over_printed(over.runge_kutta),
            paper: over.paper.map(over_printed),
            energy: over.energy.map(over_printed),
            derived: over.derived.map(over_printed),
        },
        yield_limits: si
            .yield_checks()
            .into_iter()
            .map(|check| YieldLimit {
                body: check.body.to_owned(),
                limit: check.limit,
                onset: check.onset,
                exceeded: check.is_exceeded(),
            })
            .collect(),
    }
}

impl Parameters {
    /// The numbers of a setup whose swing has this equilibrium and turns at this point and whose
    /// contact has this damping, and the order of `law`.
    pub(super) fn new(
        setup: &Setup,
        [equilibrium, turning_point]: [f64; 2],
        order: Option<u32>,
        damping: f64,
    ) -> Self {
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
            force: text(setup.force.as_ref()),
            values: setup
                .values
                .numbers()
                .into_iter()
                .map(|(name, value)| (name.name().to_owned(), value))
                .collect(),
            gamma: setup.stiffness,
            gamma_source: setup.stiffness_source.clone(),
            order,
            contact_law: match setup.loss {
                None => setup.contact_law.name(),
                Some(loss) => loss.law.name(),
            }
            .to_owned(),
            lambda: setup.loss.map(|_| damping),
            restitution: match setup.loss.map(|loss| loss.amount) {
                Some(LossAmount::Restitution(wanted)) => Some(wanted),
                Some(LossAmount::Damping(_)) | None => None,
            },
            linearisation: setup.rule.name().to_owned(),
            integrator_tolerance: setup.integrator_tolerance,
        }
    }
}

#[cfg(feature = "schema")]
fn law_names() -> Vec<&'static str> {
    let names = ContactLaw::ALL.map(ContactLaw::name);
    names.into_iter().chain(LossyLaw::ALL.map(LossyLaw::name)).collect()
}

impl ContactLawRow {
    fn from_row(row: &ContactRow) -> Self {
        let judged = |of: &dyn Fn(&ContactMotion, &ContactErrors) -> [f64; 2]| {
            let (motion, errors) = row.outcome.as_ref().ok()?;
            let [value, error] = of(motion, errors);
            Some(Judged { value, error })
        };
        Self {
            law: row.law.name().to_owned(),
            applies: row.outcome.is_ok(),
            reason: text(row.outcome.as_ref().err()),
            duration: judged(&|motion, errors| [motion.duration, errors.duration]),
            penetration: judged(&|motion, errors| [motion.depth, errors.depth]),
            peak_force: judged(&|motion, errors| [motion.peak_force, errors.peak_force]),
            max_deviation: row.outcome.as_ref().ok().map(|(_, errors)| errors.motion),
        }
    }
}

fn contact_damping(impact: &Impact) -> Option<ContactDamping> {
    let ([restitution, exit_speed], energy_lost) = impact.losses()?;
    let lossy = match &impact.contact {
        Some(DerivedContact::Lossy(contact)) => Some(contact.as_ref()),
        Some(DerivedContact::Elastic(_)) | None => None,
    };
    let hunt_crossley = lossy.and_then(|contact| match contact {
        LossyContact::HuntCrossley(contact) => Some(contact),
        LossyContact::Dashpot(_) => None,
    });
    Some(ContactDamping {
        lambda: impact.damping,
        restitution: quantity(impact, &restitution),
        exit_speed: quantity(impact, &exit_speed),
        energy_lost: quantity(impact, &energy_lost),
        peak_force: lossy.map(|contact| contact.numbers().peak_force),
        small_damping: hunt_crossley.map(|contact| {
            let value = 1.0 - 2.0 / 3.0 * contact.damping * contact.speed;
            Judged { value, error: value / contact.restitution - 1.0 }
        }),
    })
}

const READINGS: [PhaseReading; 3] =
    [PhaseReading::Paper, PhaseReading::Energy, PhaseReading::Derived];

fn quantity(impact: &Impact, quantity: &impact::ImpactQuantity) -> Quantity {
    let errors: Vec<f64> = quantity.errors().collect();
    let found = |reading| {
        let index = impact.columns.iter().position(|column| column.reading == reading);
        match index {
            Some(index) => (Some(quantity.closed_forms[index]), Some(errors[index])),
            None => (None, None),
        }
    };
    let [(paper, paper_error), (energy, energy_error), (derived, derived_error)] =
        READINGS.map(found);
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
    fn from_phase(phase: &impact::MotionPhase) -> Self {
        let state = |time: f64| {
            let (x, velocity) = phase.phase_point_at(time);
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
                Form::Cosine { amplitude, frequency, phase } => {
                    Some(Coefficients::Cosine(Cosine { amplitude, frequency, phase }))
                }
                Form::Oscillation { centre, amplitude: Complex64 { re, im }, frequency } => {
                    Some(Coefficients::Oscillation(Oscillation {
                        centre,
                        amplitude: Amplitude { re, im },
                        frequency,
                    }))
                }
                Form::Harmonics { .. } | Form::Contact { .. } => None,
            },
            displacement: PhaseDisplacement {
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
                    .map(|(harmonic, Complex64 { re, im })| PhaseHarmonic {
                        harmonic,
                        cos: re,
                        sin: -im,
                    })
                    .collect(),
            },
        }
    }

    /// The phase that the document describes.
    pub fn read(&self) -> impact::MotionPhase {
        impact::MotionPhase {
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
                    depth: self.displacement.read_depth(),
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

impl PhaseDisplacement {
    /// The depth in contact that these harmonics are.
    fn read_depth(&self) -> SineSeries {
        let sines = |rest: u32| -> Vec<f64> {
            let those = self.harmonics.iter().filter(|wave| wave.harmonic % 2 == rest);
            those.map(|wave| wave.sin).collect()
        };
        let mut depth = SineSeries::new(self.duration, self.parabola, sines(1));
        depth.even = sines(0);
        depth
    }
}

impl ImpactDocument {
    /// The three phases of the paper's reading; where that does not apply, the derived ones.
    ///
    /// # Errors
    /// A document of another kind.
    pub fn read_phases(&self) -> Result<Vec<impact::MotionPhase>, JsonError> {
        check_kind(&self.schema, DocumentKind::Impact)?;
        let phases = match self.phases.is_empty() {
            false => &self.phases,
            true => &self.derived_phases,
        };
        Ok(phases.iter().map(Phase::read).collect())
    }
}

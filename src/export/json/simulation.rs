//! Kind `simulation`: one run of equation (7).

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::text;
use crate::export::simulation::{COMPARED, Report, friction, notes, phases};
use crate::impact::{
    self, ClosedForm, ContactDeviation, Geometry, Integrator, PathSegment, Regime,
};
#[cfg(feature = "schema")]
use crate::impact::{Friction, Side};

/// One run of the paper's equation (7), event by event. Angles are in radians, time is in units of
/// 1/omega of small swings, sqrt(L/g), energies in units of m g L.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct SimulationDocument {
    /// The kind of document.
    pub schema: String,
    /// The numbers of the problem.
    pub parameters: Parameters,
    /// What damps, each damping in every form; null where only the numbers of equation (7) are
    /// known.
    pub dissipation: Option<Dissipation>,
    /// The unit of time sqrt(L/g), in seconds; null where mass, length and gravity are not known.
    pub time_unit: Option<f64>,
    /// The integrator of the run: `taylor` with the contact in a variable in which it is analytic,
    /// or `runge-kutta` phase by phase.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = INTEGRATORS.map(integrator))))]
    pub integrator: String,
    /// How the motion was found: by `integration`, or as a `chain` of closed forms.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ROUTES)))]
    pub route: String,
    /// The phases of a chain, in time; null where the motion was integrated.
    pub phases: Option<Vec<ChainPhase>>,
    /// The state at the end of the run.
    pub final_state: State,
    /// The states at the times that were asked for, in that order.
    pub samples: Vec<Sample>,
    /// Every contact with a barrier, in time.
    pub impacts: Vec<Impact>,
    /// The place of rest from which amplitudes are counted, in rad: 0, unless a barrier holds the
    /// pendulum elsewhere or it has turned over.
    pub place_of_rest: f64,
    /// When the envelope of the amplitude falls to a tenth of the first swing, in units of time;
    /// null where it does not.
    pub rest_time: Option<f64>,
    /// The same in seconds; null where there is none, or where units are not known.
    pub rest_time_in_seconds: Option<f64>,
    /// Why there is no rest time, in words; null where there is one.
    pub rest_reason: Option<String>,
    /// The last time at which x is a tenth of the first swing away from the place of rest, in units
    /// of time; null where it never is.
    pub last_crossing: Option<f64>,
    /// The rest times of the same swing; null where nothing damps it, where it hits nothing, or
    /// where the pivot moves.
    pub baseline: Option<Baseline>,
    /// The energy and the work of each force; of a chain by its formulas, whose velocities are near
    /// and do not close the books.
    pub energy: Energy,
    /// The largest energy that no work accounts for, as a fraction of the largest energy met; of a
    /// chain that of its velocities.
    pub energy_residual: f64,
    /// The time until which the motion is known to six digits; beyond it a start displaced by 1e-12
    /// of it leads elsewhere. Left out where it is known to the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub known_until: Option<f64>,
    /// Why the run ended, in words.
    pub stopped: String,
    /// Whether the run got where it was to get.
    pub complete: bool,
    /// The number of steps of the integrator.
    pub steps: usize,
    /// The same run by the other integrator, or of a chain by Taylor series; null where it was not
    /// asked for.
    pub judge: Option<Judge>,
    /// What should be known beside the numbers, in words.
    pub notes: Vec<String>,
}

/// Rest times of the same swing, in units of time; null where it does not come to rest in four
/// times the duration of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Baseline {
    /// Without a barrier.
    pub no_barrier: Option<f64>,
    /// With the same barrier, elastic.
    pub lossless_barrier: Option<f64>,
    /// With the barrier of the run: `rest_time`.
    pub this_barrier: Option<f64>,
    /// The gain of the lossless barrier by the actions of the swings; null with dry friction.
    pub geometry: Option<Geometry>,
}

/// The numbers of a run: dimensionless unless another unit is given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Parameters {
    /// Where the barriers stand.
    pub barrier: Barrier,
    /// The displacement at t = 0, in radians.
    pub start: f64,
    /// The velocity at t = 0, in radians per unit of time.
    pub speed: f64,
    /// The stiffness of the barrier.
    pub gamma: f64,
    /// Where gamma comes from, in words.
    pub gamma_source: String,
    /// The damping of the contact, by Hunt and Crossley.
    pub mu: f64,
    /// Where mu comes from, in words.
    pub mu_source: String,
    /// The viscous damping, as a fraction of the critical one.
    pub zeta: f64,
    /// The torque of dry friction, in units of m g L.
    pub alpha: f64,
    /// The law of dry friction: `exact` with sticking, or `arctangent`.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [friction(Friction::Exact), friction(Friction::Arctangent)])))]
    pub friction: String,
    /// The amplitude of the moving pivot: (A_e/L) (Omega/omega)^2.
    pub beta: f64,
    /// The frequency of the pivot over that of small swings, Omega/omega.
    pub frequency_ratio: f64,
    /// How long the run is to last, in units of time.
    pub duration: f64,
    /// The relative tolerance that was asked for.
    pub integrator_tolerance: f64,
    /// The relative tolerance of one step, a part of it.
    pub step_tolerance: f64,
}

/// What damps, each damping in every form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Dissipation {
    /// The damping of the contact.
    pub contact: ContactDissipation,
    /// The viscous damping.
    pub viscous: ViscousDissipation,
    /// The dry friction.
    pub friction: FrictionDissipation,
}

/// The damping of a contact, in every form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ContactDissipation {
    /// The form in which it is given and held fixed, by its key in a file.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = impact::ContactDamping::FORMS.map(impact::Parameter::name))))]
    pub held_fixed: String,
    /// mu of equation (7), dimensionless.
    pub mu: f64,
    /// mu/gamma, dimensionless.
    pub mu_over_gamma: f64,
    /// lambda of Hunt and Crossley, in s/m; null where units are not known.
    pub lambda: Option<f64>,
    /// c of the force (k + c d') d^(3/2), in N s/m^(5/2); null where units are not known.
    pub damping: Option<f64>,
    /// The coefficient of restitution at `touch_speed`, dimensionless; null where no barrier is
    /// touched.
    pub restitution: Option<f64>,
    /// The speed of the first touch without damping, in radians per unit of time; null where no
    /// barrier is touched.
    pub touch_speed: Option<f64>,
    /// The restitution that is given, dimensionless; null where another form is.
    pub stated_restitution: Option<f64>,
    /// The speed at which that is stated, in radians per unit of time; null where another form is
    /// given.
    pub at_speed: Option<f64>,
    /// The speed in m/s; left out if the file states no such speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_speed_si: Option<f64>,
}

/// A viscous damping, in every form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ViscousDissipation {
    /// The form in which it is given and held fixed, by its key in a file.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [impact::Parameter::Zeta.name(), impact::Parameter::Viscous.name()])))]
    pub held_fixed: String,
    /// The fraction zeta of the critical damping.
    pub zeta: f64,
    /// The coefficient c = 2 zeta m omega of a force against the velocity of the bob, in N s/m;
    /// null where units are not known.
    pub viscous: Option<f64>,
}

/// A dry friction, in every form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct FrictionDissipation {
    /// The form in which it is given and held fixed, by its key in a file.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [impact::Parameter::Alpha.name(), impact::Parameter::Torque.name()])))]
    pub held_fixed: String,
    /// The torque in units of m g L: the coefficient alpha of equation (7).
    pub alpha: f64,
    /// The torque, in N m; null where units are not known.
    pub torque: Option<f64>,
}

impl From<&impact::Dissipation> for Dissipation {
    fn from(damping: &impact::Dissipation) -> Self {
        Self {
            contact: ContactDissipation {
                held_fixed: damping.contact.form().name().to_owned(),
                mu: damping.mu,
                mu_over_gamma: damping.mu_over_gamma,
                lambda: damping.lambda,
                damping: damping.coefficient,
                restitution: damping.restitution,
                touch_speed: damping.touch_speed,
                stated_restitution: match damping.contact {
                    impact::ContactDamping::Restitution(e) => Some(e),
                    _ => None,
                },
                at_speed: damping.at_speed,
                at_speed_si: damping.at_speed_si,
            },
            viscous: ViscousDissipation {
                held_fixed: damping.viscous_form.name().to_owned(),
                zeta: damping.zeta,
                viscous: damping.viscous,
            },
            friction: FrictionDissipation {
                held_fixed: damping.friction_form.name().to_owned(),
                alpha: damping.alpha,
                torque: damping.torque,
            },
        }
    }
}

/// The places of the barriers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Barrier {
    /// The left one, in radians; null where there is none.
    pub left: Option<f64>,
    /// The right one, in radians; null where there is none.
    pub right: Option<f64>,
}

/// A state at the end of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct State {
    /// The time, in units of time.
    pub t: f64,
    /// The displacement, in radians.
    pub x: f64,
    /// Its rate, in radians per unit of time.
    pub velocity: f64,
}

/// A state that was asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Sample {
    /// The time, in units of time.
    pub t: f64,
    /// The displacement, in radians; null where the run ended before.
    pub x: Option<f64>,
    /// Its rate, in radians per unit of time; null likewise.
    pub velocity: Option<f64>,
}

/// One contact with a barrier.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Impact {
    /// When the barrier is touched, in units of time.
    pub entry_time: f64,
    /// When it is left, in units of time; null where the run ended before.
    pub exit_time: Option<f64>,
    /// The speed at the touch, in radians per unit of time; of a motion that starts inside the
    /// barrier its speed inwards then.
    pub speed_in: f64,
    /// The speed at the release, in radians per unit of time; null where the run ended before.
    pub speed_out: Option<f64>,
    /// The greatest depth, in radians.
    pub penetration: f64,
    /// speed_out / speed_in; null for a contact that did not begin with a touch, or did not end.
    pub restitution: Option<f64>,
    /// The energy that the motion has lost between touch and release, in units of m g L; null where
    /// the run ended before.
    pub energy_lost: Option<f64>,
    /// Which barrier it is.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [Side::Left.name(), Side::Right.name()])))]
    pub side: String,
    /// How far it is from the same contact by integration; null unless it is of a chain that was
    /// judged, and the integration has it.
    pub error: Option<ContactDeviation>,
}

/// A phase of a chain: a stretch of time with one formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ChainPhase {
    /// What happens: `swing`, `contact`, `rest` where dry friction holds the pendulum, or
    /// `integrated` where there is no formula.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["swing", "contact", "rest", "integrated"])))]
    pub name: String,
    /// When it begins, in units of time.
    pub start: f64,
    /// When it ends, in units of time.
    pub end: f64,
    /// x in radians as a function of t, the time since the beginning of the phase; null where there
    /// is no formula.
    pub closed_form: Option<String>,
    /// The numbers of the formula of a swing; null for another phase.
    pub swing: Option<SwingForm>,
    /// The numbers of the formula of a contact; null for another phase.
    pub contact: Option<ContactForm>,
}

/// x(t) = 2 sign asin(modulus exp(-rate t) sn(speed t + phase, parameter)), sn of Jacobi with the
/// parameter k^2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct SwingForm {
    /// 1 or -1.
    pub sign: f64,
    /// The sine of half the amplitude at the beginning, dimensionless.
    pub modulus: f64,
    /// The rate of decay, per unit of time.
    pub rate: f64,
    /// The rate of the argument of sn, per unit of time.
    pub speed: f64,
    /// The argument of sn at the beginning, dimensionless.
    pub phase: f64,
    /// The parameter of sn, the square of its modulus, dimensionless.
    pub parameter: f64,
}

/// x(t) = barrier + the sum over j from 1 of sines_j sin(j pi t/duration).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ContactForm {
    /// Where the barrier stands, in radians.
    pub barrier: f64,
    /// The duration of the contact, in units of time.
    pub duration: f64,
    /// The amplitudes of the sines, in radians.
    pub sines: Vec<f64>,
}

/// Energies and works over the run, in units of m g L.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Energy {
    /// The energy at the start, in units of m g L.
    pub start: f64,
    /// The energy at the end, in units of m g L.
    pub end: f64,
    /// The work of viscous damping, never positive, in units of m g L.
    pub viscous: f64,
    /// The work of dry friction, never positive, in units of m g L.
    pub friction: f64,
    /// The work of the damping in the contacts, in units of m g L.
    pub contact: f64,
    /// The work of the moving pivot, in units of m g L.
    pub excitation: f64,
}

/// The same run by the other integrator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Judge {
    /// The integrator.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = INTEGRATORS.map(integrator))))]
    pub integrator: String,
    /// The number of contacts it finds.
    pub impacts: usize,
    /// How far the two motions differ.
    pub max_difference: Difference,
    /// The state at its end.
    pub final_state: State,
    /// The largest energy that no work accounts for, as a fraction of the largest energy met.
    pub energy_residual: f64,
    /// Why it ended, in words.
    pub stopped: String,
}

/// The largest differences of two motions at the same times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Difference {
    /// Of the displacements, in radians.
    pub x: f64,
    /// Of the velocities, in radians per unit of time.
    pub velocity: f64,
    /// The time up to which they are compared, in units of time.
    pub until: f64,
}

/// The routes by which a motion is found.
#[cfg(feature = "schema")]
pub(super) const ROUTES: [&str; 2] = ["integration", "chain"];

#[cfg(feature = "schema")]
const INTEGRATORS: [Integrator; 3] =
    [Integrator::Taylor, Integrator::RungeKutta, Integrator::Chain];

/// The document of kind `simulation`.
///
/// ```
/// use lindstedt::export::{json, simulation::Report};
/// use lindstedt::impact::{Case, Integrator, Settings, simulate};
///
/// let (model, start) = Case { zeta: 0.05, ..Case::default() }.motion()?;
/// let motion = simulate(&model, start, Integrator::Taylor, &Settings::default())?;
/// let report = Report { motion: &motion, judge: None, sources: ["given", "given"], tolerance: 1e-10, samples: &[1.0], baseline: None, dissipation: None, units: None, known_until: None };
/// let document = json::simulation(&report);
/// assert_eq!((document.samples.len(), document.impacts.len()), (1, motion.impacts.len()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulation(report: &Report) -> SimulationDocument {
    let motion = report.motion;
    let model = &motion.model;
    let [gamma_source, mu_source] = report.sources.map(str::to_owned);
    let book = motion.energy();
    let rest = motion.rest();
    let sample = |&t: &f64| {
        let (x, velocity) = motion.path.phase_point_at(t).unzip();
        Sample { t, x, velocity }
    };
    SimulationDocument {
        schema: DocumentKind::Simulation.schema().to_owned(),
        parameters: Parameters {
            barrier: Barrier { left: model.left, right: model.right },
            start: motion.start.x,
            speed: motion.start.velocity,
            gamma: model.gamma,
            gamma_source,
            mu: model.mu,
            mu_source,
            zeta: model.zeta,
            alpha: model.alpha,
            friction: friction(model.friction).to_owned(),
            beta: model.beta,
            frequency_ratio: model.frequency_ratio,
            duration: motion.settings.duration,
            integrator_tolerance: report.tolerance,
            step_tolerance: motion.settings.relative_tolerance,
        },
        dissipation: report.dissipation.map(Dissipation::from),
        time_unit: report.units.map(impact::Units::time),
        integrator: integrator(motion.integrator).to_owned(),
        route: motion.integrator.route().to_owned(),
        phases: (motion.integrator == Integrator::Chain)
            .then(|| phases(motion).iter().map(phase).collect()),
        final_state: final_state(motion),
        samples: report.samples.iter().map(sample).collect(),
        impacts: impacts(report),
        place_of_rest: rest.place,
        rest_time: rest.time.ok(),
        rest_time_in_seconds: report.units.and_then(|units| Some(rest.time.ok()? * units.time())),
        rest_reason: text(rest.time.err()),
        last_crossing: rest.last_crossing,
        baseline: report.baseline.map(|baseline| Baseline {
            no_barrier: baseline.no_barrier.ok(),
            lossless_barrier: baseline.lossless_barrier.ok(),
            this_barrier: rest.time.ok(),
            geometry: baseline.geometry,
        }),
        energy: Energy {
            start: book.start,
            end: book.end,
            viscous: book.viscous,
            friction: book.friction,
            contact: book.contact,
            excitation: book.excitation,
        },
        energy_residual: book.residual,
        known_until: report.known_until,
        stopped: motion.stop.to_string(),
        complete: motion.stop.is_complete(),
        steps: motion.steps,
        judge: report.judge.map(|judge| self::judge(motion, judge)),
        notes: notes(report),
    }
}

/// Every contact; of a chain that is judged, with its errors.
fn impacts(report: &Report) -> Vec<Impact> {
    let motion = report.motion;
    let judge = report.judge.filter(|_| motion.integrator == Integrator::Chain);
    let errors = judge.map_or_else(Vec::new, |judge| motion.contact_deviations(judge));
    let errors = errors.into_iter().chain(std::iter::repeat(None));
    let impacts = motion.impacts.iter().zip(errors);
    impacts.map(|(contact, error)| Impact { error, ..impact(contact) }).collect()
}

fn phase(piece: &PathSegment) -> ChainPhase {
    let form = piece.closed_form();
    let empty = ChainPhase {
        name: match piece.regime {
            Regime::Stuck => "rest",
            _ => "integrated",
        }
        .to_owned(),
        start: piece.start,
        end: piece.end,
        closed_form: form.map(|form| form.to_string()),
        swing: None,
        contact: None,
    };
    match form {
        None => empty,
        Some(ClosedForm::Swing { sign, modulus, rate, speed, phase, parameter }) => ChainPhase {
            name: "swing".to_owned(),
            swing: Some(SwingForm { sign, modulus, rate, speed, phase, parameter }),
            ..empty
        },
        Some(ClosedForm::Contact { barrier, duration, sines }) => ChainPhase {
            name: "contact".to_owned(),
            contact: Some(ContactForm { barrier, duration, sines: sines.to_vec() }),
            ..empty
        },
    }
}

fn impact(impact: &impact::ContactRecord) -> Impact {
    Impact {
        entry_time: impact.entry_time,
        exit_time: impact.exit_time,
        speed_in: impact.speed_in,
        speed_out: impact.speed_out,
        penetration: impact.penetration,
        restitution: impact.restitution,
        energy_lost: impact.energy_lost,
        side: impact.side.name().to_owned(),
        error: None,
    }
}

fn judge(motion: &impact::Simulation, judge: &impact::Simulation) -> Judge {
    let difference = motion.difference(judge, COMPARED);
    Judge {
        integrator: integrator(judge.integrator).to_owned(),
        impacts: judge.impacts.len(),
        max_difference: Difference {
            x: difference.displacement,
            velocity: difference.velocity,
            until: difference.until,
        },
        final_state: final_state(judge),
        energy_residual: judge.energy().residual,
        stopped: judge.stop.to_string(),
    }
}

fn integrator(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::Taylor => "taylor",
        Integrator::RungeKutta => "runge-kutta",
        Integrator::Chain => "chain",
    }
}

fn final_state(motion: &impact::Simulation) -> State {
    State { t: motion.end_time, x: motion.end_x, velocity: motion.end_velocity }
}

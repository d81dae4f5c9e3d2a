//! Kind `materials`: the same swing against barriers of several materials.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::text;
use super::optimization::MainMassDocument;
#[cfg(feature = "schema")]
use super::simulation::ROUTES;
use super::simulation::{Barrier, Dissipation};
use crate::impact::{self, FirstContact, MaterialStudy};
#[cfg(feature = "schema")]
use crate::impact::{ContactDamping, Parameter};
use crate::report::material_sentences;

/// The same swing against barriers of several materials. Angles are in radians, time is in units of
/// 1/omega of small swings, sqrt(L/g), energies in units of m g L, unless another unit is given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct MaterialsDocument {
    /// The kind of document.
    pub schema: String,
    /// The pendulum and the run.
    pub parameters: MaterialsParameters,
    /// What damps the design at its own modulus, in every form.
    pub dissipation: Dissipation,
    /// The dampings that nobody gave, by their keys in a file: their numbers are not the paper's,
    /// which prints none.
    pub defaults: Vec<String>,
    /// The materials, in the order in which they were given.
    pub materials: Vec<MaterialRow>,
    /// The materials under each form of the damping of the contact, the given one first; empty
    /// where the contact loses nothing or no barrier is touched.
    pub held_fixed: Vec<HeldFixed>,
    /// Without a barrier.
    pub no_barrier: RestTime,
    /// What the numbers say, in words.
    pub conclusions: Vec<String>,
}

/// The pendulum and the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct MaterialsParameters {
    /// Where the barriers stand.
    pub barrier: Barrier,
    /// The displacement at t = 0, in radians.
    pub start: f64,
    /// The velocity at t = 0, in radians per unit of time.
    pub speed: f64,
    /// The mass of the pendulum, in kg.
    pub mass: f64,
    /// The radius of its sphere, in m.
    pub radius: f64,
    /// Its length, in m.
    pub length: f64,
    /// The acceleration of gravity, in m/s^2.
    pub gravity: f64,
    /// The modulus at which the damping of the contact is what is given, in Pa.
    pub modulus: f64,
    /// The unit of time sqrt(L/g), in seconds.
    pub time_unit: f64,
    /// The main mass that carries the pendulum and is to come to rest; null on a fixed pivot, where
    /// the pendulum is.
    pub main_mass: Option<MainMassDocument>,
    /// The rest times of the main mass without its damper and with the damper locked, in units of
    /// time; null where there is none, and on a fixed pivot.
    pub undamped_and_locked_rest_times: Option<[Option<f64>; 2]>,
    /// How long the motions are followed, in units of time.
    pub duration: f64,
    /// How the motions were found: by `integration`, or as a `chain` of closed forms.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ROUTES)))]
    pub route: String,
    /// The relative tolerance of one step of the integrator.
    pub step_tolerance: f64,
    /// The part of the first amplitude at which the pendulum, or the main mass, rests.
    pub rest_fraction: f64,
}

/// A rest time, or why there is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct RestTime {
    /// The rest time, in units of time; null where there is none.
    pub rest_time: Option<f64>,
    /// The same in seconds; null likewise.
    pub rest_time_in_seconds: Option<f64>,
    /// Why there is none, in words; null where there is one.
    pub rest_reason: Option<String>,
}

/// A material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct MaterialRow {
    /// Its name.
    pub name: String,
    /// The modulus of its contact with the sphere, in Pa.
    pub modulus: f64,
    /// The stiffness of its contact by equation (8), dimensionless.
    pub gamma: f64,
    /// Whether it has a damping of its own.
    pub own_damping: bool,
    /// What damps its motion, in every form.
    pub dissipation: Dissipation,
    /// The first contact; null where the barrier is not touched, or not left again.
    pub first_contact: Option<FirstContact>,
    /// The contacts that begin before it rests, or in the whole run where it does not.
    pub impacts: usize,
    /// The energy of the swing, or of main mass and pendulum, after each of them, in units of m g L.
    pub energies: Vec<f64>,
    /// When it rests.
    pub rest: RestTime,
    /// The least and the greatest rest time of starts 0.03 % smaller and larger, in units of time,
    /// where a main mass is followed by closed forms and rests; null otherwise, and where one of them
    /// does not rest.
    pub nearby_rest_times: Option<[f64; 2]>,
    /// When it rests where the contact loses nothing, mu = 0.
    pub lossless: RestTime,
    /// Stated yield limits beside the pressure of the first contact.
    pub yield_checks: Vec<MaterialYieldCheck>,
}

/// A stated yield limit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct MaterialYieldCheck {
    /// The body: `sphere` or `barrier`.
    pub body: String,
    /// Its yield limit Y, in Pa.
    pub limit: f64,
    /// The peak pressure at which it begins to yield, 1.6 Y, in Pa.
    pub onset: f64,
    /// Whether the peak pressure exceeds that, so that the law of Hertz is outside its range.
    pub exceeded: bool,
}

/// The materials under one form of the damping of the contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct HeldFixed {
    /// The form, by its key in a file.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ContactDamping::FORMS.map(Parameter::name))))]
    pub form: String,
    /// Its number, the same for every material, in `unit`.
    pub value: f64,
    /// The unit of that number; empty where it has none.
    pub unit: String,
    /// The speed at which a restitution is stated, in radians per unit of time; null for other
    /// forms.
    pub at_speed: Option<f64>,
    /// mu/gamma of each material, dimensionless.
    pub mu_over_gamma: Vec<f64>,
    /// The restitution of each material at the speed of the first touch without damping; null where
    /// no barrier is touched.
    pub restitutions: Vec<Option<f64>>,
    /// The rest time of each material, in units of time; null where it does not rest.
    pub rest_times: Vec<Option<f64>>,
    /// How far the rest times are apart, latest/soonest - 1; null where a material does not rest.
    pub spread: Option<f64>,
}

/// The document of kind `materials`.
///
/// ```
/// use lindstedt::impact::{MaterialQuestion, study_materials};
///
/// let document = lindstedt::export::json::materials(&study_materials(MaterialQuestion::default())?);
/// assert_eq!(document.materials[1].name, "Aluminum alloy (6061-T6)");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn materials(study: &MaterialStudy) -> MaterialsDocument {
    let rest = |time: Result<f64, impact::NoRest>| RestTime {
        rest_time: time.ok(),
        rest_time_in_seconds: time.ok().map(|time| study.seconds(time)),
        rest_reason: text(time.err()),
    };
    let row = |row: &impact::MaterialRow| MaterialRow {
        name: row.material.name.clone(),
        modulus: row.material.modulus.value(),
        gamma: row.gamma,
        own_damping: row.material.damping.is_some(),
        dissipation: Dissipation::from(&row.dissipation),
        first_contact: row.first,
        impacts: row.course.impacts.len(),
        energies: row.course.energies.clone(),
        rest: rest(row.course.rest_time),
        nearby_rest_times: row.nearby,
        lossless: rest(row.lossless),
        yield_checks: row.yield_checks.iter().map(yield_check).collect(),
    };
    let design = &study.question.case.design;
    let settings = &study.question.settings;
    MaterialsDocument {
        schema: DocumentKind::Materials.schema().to_owned(),
        parameters: MaterialsParameters {
            barrier: Barrier { left: study.model.left, right: study.model.right },
            start: study.start.x,
            speed: study.start.velocity,
            mass: design.mass,
            radius: design.radius,
            length: design.length,
            gravity: design.gravity,
            modulus: design.modulus,
            time_unit: study.units.time(),
            main_mass: study.question.main_mass.map(MainMassDocument::from),
            undamped_and_locked_rest_times: study
                .undamped_and_locked()
                .map(|others| [others.without.rest_time, others.locked.rest_time]),
            duration: settings.duration,
            route: study.question.integrator.route().to_owned(),
            step_tolerance: settings.relative_tolerance,
            rest_fraction: impact::REST_FRACTION,
        },
        dissipation: Dissipation::from(&study.dissipation),
        defaults: study.question.defaults.iter().map(|key| key.name().to_owned()).collect(),
        materials: study.rows.iter().map(row).collect(),
        held_fixed: study.held_fixed.iter().map(held_fixed).collect(),
        no_barrier: rest(study.no_barrier),
        conclusions: material_sentences(study),
    }
}

fn yield_check(check: &impact::YieldCheck) -> MaterialYieldCheck {
    MaterialYieldCheck {
        body: check.body.to_owned(),
        limit: check.limit,
        onset: check.onset,
        exceeded: check.is_exceeded(),
    }
}

fn held_fixed(held: &impact::HeldFixed) -> HeldFixed {
    HeldFixed {
        form: held.damping.form().name().to_owned(),
        value: held.damping.value(),
        unit: held.damping.form().unit().to_owned(),
        at_speed: held.at_speed,
        mu_over_gamma: held.ratios.clone(),
        restitutions: held.restitutions.clone(),
        rest_times: held.rest_times.iter().map(|time| time.ok()).collect(),
        spread: held.spread(),
    }
}

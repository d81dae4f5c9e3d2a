//! The choice of the material of a barrier: the same swing against barriers that differ in their
//! modulus alone.
//!
//! In: a design, its dampings, and materials. Out: for each material the contact, the motion until
//! it rests, and the dependence of the rest time on the form of the damping that is held fixed
//! while the modulus changes,
//!
//! ```text
//! gamma = (4/3) E sqrt(R) L^(3/2)/(m g)                                      equation (8), grows with E
//! mu fixed, or c of (k + c d') d^(3/2)           mu/gamma falls as 1/E: a soft barrier loses more
//! mu/gamma fixed, or lambda, or a restitution at a speed     the restitution e((mu/gamma) v) is that of any E
//! ```
//!
//! The given damping applies at the modulus of the design; every other form is held fixed at its
//! value there. With a main mass that carries the pendulum it is the main mass that is to come to
//! rest; `motion` follows either.

mod motion;

use thiserror::Error;

use super::baseline::BASELINE_DURATIONS;
use super::case::Case;
use super::dissipation::{ContactDamping, Dissipation, SpeedUnit};
use super::hertz;
use super::model::{Model, ModelError, Start};
use super::parameter::Parameter;
use super::primary::{MainMass, PrimaryError, UndampedAndLocked};
use super::si::YieldCheck;
use super::simulate::{SimulationError, simulate};
use super::simulation::{ContactRecord, Integrator, NoRest, Settings, SimulationStop};
use super::units::{FIRST_YIELD, Modulus, Units};
use motion::StudiedCase;
pub use motion::StudiedMotion;
pub(crate) use motion::impacts_until;

/// The default materials of a study, with their elastic moduli, Pa.
pub const DEFAULT_MATERIALS: [(&str, f64); 3] = [
    ("Steel alloy (ASTM-A242)", 200e9),
    ("Aluminum alloy (6061-T6)", 70e9),
    ("Polyester elastomer", 0.2e9),
];

/// The default damping ratio zeta of a study.
pub const DEFAULT_ZETA: f64 = 0.02;

/// The default lambda, s/m, of a study: mu/gamma = 0.1 for the default design, sqrt(g L) = 0.817
/// m/s.
pub fn default_lambda() -> f64 {
    let design = hertz::StiffnessDesign::default();
    0.1 / (design.gravity * design.length).sqrt()
}

/// Duration of the motions of a study if none is given, in units of 1/omega.
pub const DEFAULT_DURATION: f64 = 500.0;

/// A material of a barrier.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// The modulus of its contact with the sphere.
    pub modulus: Modulus,
    /// Its yield limit, Pa, where one is stated.
    pub yield_limit: Option<f64>,
    /// The damping of its contact, where it has one of its own.
    pub damping: Option<ContactDamping>,
    /// The speed at which its restitution is stated, in the unit of the case.
    pub at_speed: Option<f64>,
}

impl Material {
    /// The [`DEFAULT_MATERIALS`], each by its modulus alone: the sphere counts as rigid and the
    /// barrier as a body without Poisson's ratio.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::Material;
    ///
    /// let names: Vec<String> = Material::defaults().into_iter().map(|material| material.name).collect();
    /// assert_eq!(names[2], "Polyester elastomer");
    /// ```
    pub fn defaults() -> Vec<Self> {
        let row = |(name, modulus): (&str, f64)| Self {
            name: name.to_owned(),
            modulus: Modulus::BarrierAlone(modulus),
            yield_limit: None,
            damping: None,
            at_speed: None,
        };
        DEFAULT_MATERIALS.into_iter().map(row).collect()
    }
}

/// A study of materials: the question.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialQuestion {
    /// The pendulum and its dampings. The given damping of the contact applies at its modulus.
    pub case: Case,
    /// The materials.
    pub materials: Vec<Material>,
    /// The yield limit of the sphere, Pa, where one is stated.
    pub sphere_yield: Option<f64>,
    /// Duration and accuracy of the motions.
    pub settings: Settings,
    /// The main mass that carries the pendulum and is to come to rest; `None` on a fixed pivot.
    pub main_mass: Option<MainMass>,
    /// The method that follows them; pictures use the same one.
    pub integrator: Integrator,
    /// The dampings that were not given, for which the defaults are used.
    pub defaults: Vec<Parameter>,
}

impl Default for MaterialQuestion {
    /// The default design and materials, with the default dissipation.
    fn default() -> Self {
        Self {
            case: Case {
                contact_damping: ContactDamping::Lambda(default_lambda()),
                zeta: DEFAULT_ZETA,
                ..Case::default()
            },
            materials: Material::defaults(),
            sphere_yield: None,
            main_mass: None,
            settings: Settings { duration: DEFAULT_DURATION, ..Settings::default() },
            integrator: Integrator::Taylor,
            defaults: vec![Parameter::Lambda, Parameter::Zeta],
        }
    }
}

/// The reason why there is no study.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MaterialsError {
    /// There is no material.
    #[error("there is no material: give one as [[material]] with a name and a modulus")]
    NoMaterial,
    /// The design.
    #[error(transparent)]
    Case(#[from] ModelError),
    /// A material whose parameters are not admissible.
    #[error("material `{name}`: {error}")]
    Material {
        /// Its name.
        name: String,
        /// The reason.
        error: ModelError,
    },
    /// A motion that cannot begin.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A motion of a main mass that cannot begin.
    #[error(transparent)]
    MainMass(#[from] PrimaryError),
}

/// The motion against one barrier until it rests.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionToRest {
    /// The time at which it rests, in units of 1/omega.
    pub rest_time: Result<f64, NoRest>,
    /// The contacts until then; all of them where it does not rest.
    pub impacts: Vec<ContactRecord>,
    /// The energy of the swing, or of main mass and pendulum, after each of them that ended, in
    /// units of m g L.
    pub energies: Vec<f64>,
    /// The reason why it was followed no further.
    pub stop: SimulationStop,
}

/// Follows one motion until it rests; every study gets its rest times here.
///
/// # Errors
/// As [`simulate`].
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{Integrator, Model, Settings, Start, course};
///
/// let model = Model { zeta: 0.02, mu: 3e6, ..Model::default() };
/// let found = course(&model, Start::default(), Integrator::Taylor, &Settings { duration: 200.0, ..Settings::default() })?;
/// assert!(found.rest_time? < 100.0 && found.energies[1] < found.energies[0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn course(
    model: &Model,
    start: Start,
    integrator: Integrator,
    settings: &Settings,
) -> Result<MotionToRest, SimulationError> {
    let settings = Settings { keep_path: false, ..*settings };
    Ok(MotionToRest::from(&simulate(model, start, integrator, &settings)?))
}

/// The first contact of a barrier.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FirstContact {
    /// The speed at the touch, in m/s.
    pub speed: f64,
    /// How long it lasts, in seconds.
    pub duration: f64,
    /// How deep it goes, in m.
    pub penetration: f64,
    /// The greatest force, that of the damping included, in N.
    pub peak_force: f64,
    /// The pressure of Hertz in the middle of the contact at the greatest depth, in Pa.
    pub peak_pressure: f64,
    /// The coefficient of restitution, dimensionless.
    pub restitution: f64,
}

/// One material.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MaterialRow {
    /// The material.
    pub material: Material,
    /// The dimensionless stiffness of its contact, equation (8).
    pub gamma: f64,
    /// Its damping, in every form.
    pub dissipation: Dissipation,
    /// The first contact; `None` if the barrier is not touched, or not left again.
    pub first: Option<FirstContact>,
    /// The motion until it rests.
    pub course: MotionToRest,
    /// The least and the greatest rest time of starts nearby, in units of 1/omega, where closed forms
    /// follow a main mass that rests; `None` otherwise, and if a start nearby does not rest.
    pub nearby: Option<[f64; 2]>,
    /// The rest time of the same barrier without loss, mu = 0, in units of 1/omega.
    pub lossless: Result<f64, NoRest>,
    /// Its stated yield limit, and that of the sphere, beside the pressure of the first contact.
    pub yield_checks: Vec<YieldCheck>,
}

/// The materials under one form of the contact damping, held fixed at what it is for the modulus of
/// the design.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct HeldFixed {
    /// The form and its number.
    pub damping: ContactDamping,
    /// The speed at which a restitution is stated, in units of L omega.
    pub at_speed: Option<f64>,
    /// mu/gamma of each material.
    pub ratios: Vec<f64>,
    /// The restitution of each material at the first touch without damping.
    pub restitutions: Vec<Option<f64>>,
    /// The rest time of each material, in units of 1/omega.
    pub rest_times: Vec<Result<f64, NoRest>>,
}

impl HeldFixed {
    /// The materials that rest first and last, by their numbers; `None` if one of them does not
    /// rest.
    pub fn extremes(&self) -> Option<[usize; 2]> {
        let times: Vec<f64> = self.rest_times.iter().copied().collect::<Result<_, _>>().ok()?;
        let numbers = 0..times.len();
        let by_time = |one: &usize, other: &usize| times[*one].total_cmp(&times[*other]);
        Some([numbers.clone().min_by(by_time)?, numbers.max_by(by_time)?])
    }

    /// (latest - soonest)/soonest of the rest times; `None` if a material does not rest.
    pub fn spread(&self) -> Option<f64> {
        let [first, last] = self.extremes()?.map(|number| self.rest_times[number]);
        let (first, last) = (first.ok()?, last.ok()?);
        Some((last - first) / first)
    }
}

/// A study of materials: the answer.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MaterialStudy {
    /// The question that this answers.
    pub question: MaterialQuestion,
    /// The pendulum in SI units.
    pub units: Units,
    /// The equation of the design, at its own modulus.
    pub model: Model,
    /// The initial state of the motions.
    pub start: Start,
    /// The damping of the design, in every form.
    pub dissipation: Dissipation,
    /// The materials, in the order in which they were given.
    pub rows: Vec<MaterialRow>,
    /// The rest time without a barrier, in units of 1/omega.
    pub no_barrier: Result<f64, NoRest>,
    /// The materials under every form of the contact damping, the given one first; empty if the
    /// contact is lossless or never touched.
    pub held_fixed: Vec<HeldFixed>,
}

/// The motions of one material, from which its part of a study follows.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialMotions {
    /// The first contact; `None` if the barrier is not touched, or not left again.
    pub first: Option<FirstContact>,
    /// The motion until it rests.
    pub course: MotionToRest,
    /// The least and the greatest rest time of starts nearby, in units of 1/omega, where closed forms
    /// follow a main mass that rests; `None` otherwise, and if a start nearby does not rest.
    pub nearby: Option<[f64; 2]>,
    /// The rest time of the same barrier without loss, in units of 1/omega.
    pub lossless: Result<f64, NoRest>,
    /// The rest time under every form of the contact damping, the given one first, in units of
    /// 1/omega; empty if its contact is lossless or does not occur.
    pub held: Vec<Result<f64, NoRest>>,
}

/// Follows the motion for every material of a study.
///
/// # Errors
/// [`MaterialsError`]: no material, or a design or a material that is not admissible.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{MaterialQuestion, study_materials};
///
/// let study = study_materials(MaterialQuestion::default())?;
/// let spread = |form: &str| study.held_fixed.iter().find(|held| held.damping.form().name() == form)?.spread();
/// assert!(spread("lambda").is_some_and(|spread| spread < 0.01)); // the modulus says nothing
/// assert!(spread("mu").is_some_and(|spread| spread > 0.1)); // it decides
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn study_materials(question: MaterialQuestion) -> Result<MaterialStudy, MaterialsError> {
    let motions = (0..question.materials.len()).map(|number| material_motions(&question, number));
    let motions = motions.collect::<Result<_, _>>()?;
    study_from_motions(question, motions)
}

/// Follows the motions of the material of this number, counted from 0; they do not depend on the
/// other materials.
///
/// # Errors
/// As [`study_materials`]; a material that does not exist has no motions.
pub fn material_motions(
    question: &MaterialQuestion,
    number: usize,
) -> Result<MaterialMotions, MaterialsError> {
    let material = question.materials.get(number).ok_or(MaterialsError::NoMaterial)?;
    let StudyDesign { case: design, dissipation } = StudyDesign::new(question)?;
    let (integrator, settings) = (question.integrator, &question.settings);
    let own = question.studied(material, &question.own_case(material), &design.units)?;
    let course = own.course(integrator, settings)?;
    let first = match course.impacts.first() {
        Some(impact) => own.first_contact(impact, integrator, settings)?,
        None => None,
    };
    let nearby = match course.rest_time {
        Ok(_) => own.nearby_rest_times(integrator, settings)?,
        Err(_) => None,
    };
    let lossless = StudiedCase { model: Model { mu: 0.0, ..own.model }, ..own };
    let lossless = lossless.course(integrator, &with_longer_duration(settings))?.rest_time;
    let held = match design.model.mu > 0.0 && first.is_some() {
        true => rest_times_held_fixed(question, material, &dissipation)?,
        false => vec![],
    };
    Ok(MaterialMotions { first, course, nearby, lossless, held })
}

/// Makes the study of the motions of all its materials, in their order.
///
/// # Errors
/// As [`study_materials`].
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{MaterialQuestion, material_motions, study_from_motions, study_materials};
///
/// let question = MaterialQuestion::default();
/// let motions = (0..3).map(|number| material_motions(&question, number)).collect::<Result<_, _>>()?;
/// assert_eq!(study_from_motions(question.clone(), motions)?, study_materials(question)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn study_from_motions(
    question: MaterialQuestion,
    motions: Vec<MaterialMotions>,
) -> Result<MaterialStudy, MaterialsError> {
    let StudyDesign { case, dissipation } = StudyDesign::new(&question)?;
    let StudiedCase { model, start, units, .. } = case;
    let loses = model.mu > 0.0 && motions.iter().any(|motions| motions.first.is_some());
    let (mut rows, mut held) = (Vec::new(), Vec::new());
    for (material, motions) in question.materials.iter().zip(motions) {
        held.push(match (loses, motions.held.is_empty()) {
            // It is not touched itself, but another one is.
            (true, true) => rest_times_held_fixed(&question, material, &dissipation)?,
            _ => motions.held.clone(),
        });
        rows.push(row(&question, &units, &dissipation, material, motions)?);
    }
    let held_fixed = match loses {
        true => held_fixed(&question, &dissipation, &held)?,
        false => vec![],
    };
    let without = StudiedCase { model: Model { left: None, right: None, ..model }, ..case };
    let longer = with_longer_duration(&question.settings);
    let no_barrier = without.course(question.integrator, &longer)?.rest_time;
    Ok(MaterialStudy { units, model, start, rows, no_barrier, dissipation, held_fixed, question })
}

/// The design of a study, at its own modulus.
struct StudyDesign {
    case: StudiedCase,
    dissipation: Dissipation,
}

impl StudyDesign {
    /// The design of this question.
    ///
    /// # Errors
    /// As [`study_materials`].
    fn new(question: &MaterialQuestion) -> Result<Self, MaterialsError> {
        if question.materials.is_empty() {
            return Err(MaterialsError::NoMaterial);
        }
        let case = question.case;
        let (model, start) = case.motion()?;
        let units = Units {
            mass: case.design.mass,
            length: case.design.length,
            gravity: case.design.gravity,
            radius: Some(case.design.radius),
            modulus: None,
            sphere_yield: question.sphere_yield,
            barrier_yield: None,
        };
        let studied = StudiedCase { model, start, units, main_mass: question.main_mass };
        let mut dissipation = case.dissipation(Some(&units))?;
        if question.main_mass.is_some() {
            let speed = studied.carried_touch_speed(question.settings.duration)?;
            dissipation = dissipation.touched_at(speed);
        }
        Ok(Self { case: studied, dissipation })
    }
}

/// The settings of a motion that rests later.
fn with_longer_duration(settings: &Settings) -> Settings {
    Settings { duration: BASELINE_DURATIONS * settings.duration, ..*settings }
}

impl MaterialQuestion {
    /// The case of a material, with this damping of its contact; the speed is in the unit of the
    /// case.
    fn case_of(&self, material: &Material, damping: ContactDamping, at_speed: Option<f64>) -> Case {
        let mut case = self.case;
        case.gamma = None;
        case.contact_damping = damping;
        case.at_speed = at_speed;
        case.design.modulus = material.modulus.value();
        case
    }

    /// The case of a material as requested: with its own damping, or with that of the design.
    fn own_case(&self, material: &Material) -> Case {
        match material.damping {
            Some(damping) => self.case_of(material, damping, material.at_speed),
            None => self.case_of(material, self.case.contact_damping, self.case.at_speed),
        }
    }

    /// The motion against the barrier of a material.
    fn studied(
        &self,
        material: &Material,
        case: &Case,
        units: &Units,
    ) -> Result<StudiedCase, MaterialsError> {
        let (model, start) = Self::motion_of(material, case)?;
        Ok(StudiedCase { model, start, units: *units, main_mass: self.main_mass })
    }

    /// The dampings of a material in every form; the speed of the first touch beside a main mass is
    /// that of `design`, because the flight to it does not depend on the barrier.
    fn dissipation_of(
        &self,
        case: &Case,
        units: Option<&Units>,
        design: &Dissipation,
    ) -> Result<Dissipation, MaterialsError> {
        let dissipation = case.dissipation(units)?;
        Ok(match self.main_mass {
            None => dissipation,
            Some(_) => dissipation.touched_at(design.touch_speed),
        })
    }

    /// The equation of a material, and its start.
    fn motion_of(material: &Material, case: &Case) -> Result<(Model, Start), MaterialsError> {
        case.motion()
            .map_err(|error| MaterialsError::Material { name: material.name.clone(), error })
    }
}

fn row(
    question: &MaterialQuestion,
    units: &Units,
    design: &Dissipation,
    material: &Material,
    motions: MaterialMotions,
) -> Result<MaterialRow, MaterialsError> {
    let MaterialMotions { first, course, nearby, lossless, .. } = motions;
    let case = question.own_case(material);
    let (model, _) = MaterialQuestion::motion_of(material, &case)?;
    let limits = [("sphere", question.sphere_yield), ("barrier", material.yield_limit)];
    let checks = limits.into_iter().filter_map(|(body, limit)| {
        let limit = limit?;
        Some(YieldCheck { body, limit, onset: FIRST_YIELD * limit, pressure: first?.peak_pressure })
    });
    Ok(MaterialRow {
        gamma: model.gamma,
        dissipation: question.dissipation_of(&case, Some(units), design)?,
        yield_checks: checks.collect(),
        first,
        nearby,
        lossless,
        course,
        material: material.clone(),
    })
}

/// The forms of the damping of the design, the given one first, each with the speed at which a
/// restitution is stated.
fn forms(dissipation: &Dissipation) -> Vec<(ContactDamping, Option<f64>)> {
    let given = dissipation.contact;
    let form = |form: Parameter| match form {
        Parameter::Mu => Some(ContactDamping::Mu(dissipation.mu)),
        Parameter::MuOverGamma => Some(ContactDamping::MuOverGamma(dissipation.mu_over_gamma)),
        Parameter::Lambda => dissipation.lambda.map(ContactDamping::Lambda),
        Parameter::Restitution => dissipation.restitution.map(ContactDamping::Restitution),
        Parameter::ContactDamping => dissipation.coefficient.map(ContactDamping::Coefficient),
        _ => None,
    };
    let others = ContactDamping::FORMS.into_iter().filter(|form| *form != given.form());
    let with_speed = |damping: ContactDamping| match damping {
        ContactDamping::Restitution(_) => {
            (damping, dissipation.at_speed.or(dissipation.touch_speed))
        }
        _ => (damping, None),
    };
    std::iter::once(given).chain(others.filter_map(form)).map(with_speed).collect()
}

/// The case of a material under a form of the damping of the design.
fn case_held_fixed(
    question: &MaterialQuestion,
    material: &Material,
    (damping, at_speed): (ContactDamping, Option<f64>),
) -> Case {
    Case { speed_unit: SpeedUnit::RadOmega, ..question.case_of(material, damping, at_speed) }
}

/// The rest times of a material under every form of the damping of the design.
fn rest_times_held_fixed(
    question: &MaterialQuestion,
    material: &Material,
    dissipation: &Dissipation,
) -> Result<Vec<Result<f64, NoRest>>, MaterialsError> {
    let units = StudyDesign::new(question)?.case.units;
    let rest_time = |form| {
        let case = case_held_fixed(question, material, form);
        let studied = question.studied(material, &case, &units)?;
        Ok(studied.course(question.integrator, &question.settings)?.rest_time)
    };
    forms(dissipation).into_iter().map(rest_time).collect()
}

/// The materials under every form of the damping of the design, the given one first; `rest_times`
/// are those of each material.
fn held_fixed(
    question: &MaterialQuestion,
    dissipation: &Dissipation,
    rest_times: &[Vec<Result<f64, NoRest>>],
) -> Result<Vec<HeldFixed>, MaterialsError> {
    let mut found = Vec::new();
    for (number, (damping, at_speed)) in forms(dissipation).into_iter().enumerate() {
        let mut held = HeldFixed {
            damping,
            at_speed,
            ratios: vec![],
            restitutions: vec![],
            rest_times: rest_times.iter().filter_map(|times| times.get(number).copied()).collect(),
        };
        for material in &question.materials {
            let case = case_held_fixed(question, material, (damping, at_speed));
            let (model, _) = MaterialQuestion::motion_of(material, &case)?;
            held.ratios.push(model.mu / model.gamma);
            held.restitutions.push(question.dissipation_of(&case, None, dissipation)?.restitution);
        }
        found.push(held);
    }
    Ok(found)
}

impl MaterialStudy {
    /// The softest and the hardest material, by their numbers; the first of equals.
    pub fn softest_and_hardest(&self) -> [usize; 2] {
        let (mut softest, mut hardest) = (0, 0);
        for (number, row) in self.rows.iter().enumerate() {
            if row.gamma < self.rows[softest].gamma {
                softest = number;
            }
            if row.gamma > self.rows[hardest].gamma {
                hardest = number;
            }
        }
        [softest, hardest]
    }

    /// Whether a softer material always rests sooner (true) or always later (false); `None` if
    /// neither holds, or one does not rest.
    pub fn order(&self, held: &HeldFixed) -> Option<bool> {
        let mut rests: Vec<(f64, f64)> = Vec::new();
        for (row, time) in self.rows.iter().zip(&held.rest_times) {
            rests.push((row.gamma, time.ok()?));
        }
        rests.sort_by(|one, other| one.0.total_cmp(&other.0));
        let always = |sooner: fn(f64, f64) -> bool| {
            rests.windows(2).all(|pair| sooner(pair[0].1, pair[1].1))
        };
        match (always(|soft, hard| soft < hard), always(|soft, hard| soft > hard)) {
            (true, false) => Some(true),
            (false, true) => Some(false),
            _ => None,
        }
    }

    /// The rest time in seconds.
    pub fn seconds(&self, rest_time: f64) -> f64 {
        self.units.time() * rest_time
    }

    /// The motion of a material as a function of time, over this duration, with the requested
    /// damping or with this form of it.
    ///
    /// # Errors
    /// As [`study_materials`]; a row that does not exist has no motion.
    pub fn motion(
        &self,
        row: usize,
        held: Option<&HeldFixed>,
        duration: f64,
    ) -> Result<StudiedMotion, MaterialsError> {
        let material = self.question.materials.get(row).ok_or(MaterialsError::NoMaterial)?;
        let case = match held {
            None => self.question.own_case(material),
            Some(held) => case_held_fixed(&self.question, material, (held.damping, held.at_speed)),
        };
        let (model, _) = MaterialQuestion::motion_of(material, &case)?;
        self.follow(model, duration)
    }

    /// The motion of the same swing without a barrier, or with that of a material without loss.
    ///
    /// # Errors
    /// As [`MaterialStudy::motion`].
    pub fn motion_without(
        &self,
        barrier_of: Option<usize>,
        duration: f64,
    ) -> Result<StudiedMotion, MaterialsError> {
        let model = match barrier_of.and_then(|row| self.rows.get(row)) {
            None => Model { left: None, right: None, ..self.model },
            Some(row) => Model { gamma: row.gamma, mu: 0.0, ..self.model },
        };
        self.follow(model, duration)
    }

    /// The main mass without its damper and with the damper locked; `None` on a fixed pivot.
    pub fn undamped_and_locked(&self) -> Option<UndampedAndLocked> {
        let main_mass = self.question.main_mass?;
        Some(main_mass.primary(&self.units).undamped_and_locked())
    }

    fn follow(&self, model: Model, duration: f64) -> Result<StudiedMotion, MaterialsError> {
        let main_mass = self.question.main_mass;
        let studied = StudiedCase { model, start: self.start, units: self.units, main_mass };
        let settings = Settings { duration, keep_path: true, ..self.question.settings };
        studied.follow(self.question.integrator, &settings)
    }
}

//! The document: what a problem file may hold, section by section, and the defaults of what it
//! leaves out.

use crate::symbol::Symbol;
use std::collections::BTreeMap;

use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::impact::hertz::StiffnessDesign;
use crate::impact::{ContactDamping, DEFAULT_AMPLITUDE, DEFAULT_BARRIER};
use crate::solution::Degrees;

/// A problem file as it was written.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Problem {
    /// The equation of motion, for formulas; several, as a list or separated by `;`, for what takes
    /// coupled equations.
    #[serde(deserialize_with = "equations")]
    pub equation: Option<String>,
    /// The name of a method.
    pub method: Option<String>,
    /// The order of the expansion; for an impact, that of the frequency law of the approach.
    pub order: Option<Order>,
    /// The name of the small parameter.
    pub small: Option<String>,
    /// The amplitude convention: `initial` or `first-harmonic`.
    pub amplitude: Option<String>,
    /// The equilibrium to swing about: `"x = 1"`.
    pub about: Option<String>,
    /// The resonance: `"1:3"`, Omega to omega0, of one coordinate; relations between frequencies of
    /// coupled equations, `"omega2 = 2*omega1, Omega = omega2"`.
    pub resonance: Option<String>,
    /// The parameter that varies, and its range: `"Omega=0.5:1.5"`.
    pub vary: Option<String>,
    /// Periods of the drive in a period of the motion.
    pub periods: Option<u32>,
    /// The quantity of coupled equations that is listed, in their coordinates: `"x - y"`.
    pub of: Option<String>,
    /// A second parameter, and its range: `"F=0.1:0.5"`.
    pub along: Option<String>,
    /// Values for `--at`: numbers, or text such as "pi/3".
    pub values: toml::Table,
    /// The swing.
    pub pendulum: Pendulum,
    /// The barrier.
    pub contact: Contact,
    /// Damping of the swing.
    pub damping: Damping,
    /// Motion of the pivot.
    pub excitation: Excitation,
    /// Mass, radius, length, modulus, gravity.
    pub design: DesignSection,
    /// The sphere that meets the barrier.
    pub sphere: SphereSection,
    /// The barrier as a body.
    pub barrier: BarrierSection,
    /// Duration and accuracy of integrations.
    pub run: Run,
    /// The main mass that carries the pendulum.
    pub primary: Option<PrimarySection>,
    /// A mechanism by its energies.
    pub lagrangian: Option<LagrangianSection>,
    /// The units of its coordinates and parameters.
    pub units: BTreeMap<String, String>,
    /// The materials of a study, or those a search chooses from.
    pub material: Vec<MaterialSection>,
    /// Walls; those that give way are terms of the equations once the file is read.
    pub wall: Vec<WallSection>,
    /// The variables of a search for the best design, and its limits.
    pub limits: LimitsSection,
    /// The options of its genetic algorithm.
    pub genetic: GeneticSection,
    /// The keys that are given, as [`keys`](super::keys) names them: what is absent has its
    /// default.
    #[serde(skip)]
    pub given: Vec<String>,
    /// The values that win over a key that says the same.
    #[serde(skip)]
    pub overriding: Vec<String>,
    /// Letters of the energies that cancel in the equations of motion.
    #[serde(skip)]
    pub cancelled: Vec<Symbol>,
}

/// An equation, or a list of them, which are joined by `; `.
fn equations<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<String>, D::Error> {
    struct Equations;

    impl<'de> Visitor<'de> for Equations {
        type Value = String;

        fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            formatter.write_str("a string")
        }

        fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<String, E> {
            Ok(text.to_owned())
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<String, A::Error> {
            let mut equations: Vec<String> = Vec::new();
            while let Some(equation) = list.next_element()? {
                equations.push(equation);
            }
            Ok(equations.join("; "))
        }
    }

    deserializer.deserialize_any(Equations).map(Some)
}

/// A whole number, or the degrees of an approximant: `order = 4`, `order = [2, 1]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged, expecting = "expected a whole number, or two: [numerator, denominator]")]
pub enum Order {
    /// The highest power kept, or what the method counts.
    Power(u32),
    /// The degrees of an approximant.
    Degrees(#[serde(deserialize_with = "degrees")] Degrees),
}

impl Order {
    /// The whole number, where it is one.
    pub fn power(self) -> Option<u32> {
        match self {
            Self::Power(order) => Some(order),
            Self::Degrees(_) => None,
        }
    }

    /// The degrees, where it is some.
    pub fn degrees(self) -> Option<Degrees> {
        match self {
            Self::Power(_) => None,
            Self::Degrees(degrees) => Some(degrees),
        }
    }
}

fn degrees<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Degrees, D::Error> {
    let list = Vec::<u32>::deserialize(deserializer)?;
    // The meaning of an order is given by its type.
    Degrees::from_list(&list).ok_or_else(|| D::Error::custom("no degrees"))
}

/// `[pendulum]`: released from rest at `x = -amplitude`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Pendulum {
    /// A, rad.
    pub amplitude: f64,
    /// x_c, rad, or `[left, right]`, or `false` for none.
    pub barrier: Barrier,
    /// The side of its position on which a single barrier is: `right`, or `left` with the release
    /// at x = amplitude.
    pub side: Option<BarrierSide>,
    /// x(0), rad, where it is not -amplitude.
    pub start: Option<f64>,
    /// x'(0), rad times omega, where it is not 0.
    pub speed: Option<f64>,
    /// Mass, kg: the same as `[design] mass`.
    pub mass: Option<f64>,
    /// Length, m: the same as `[design] length`.
    pub length: Option<f64>,
    /// Acceleration of gravity, m/s^2: the same as `[design] gravity`.
    pub gravity: Option<f64>,
}

/// `[sphere]`, SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SphereSection {
    /// Radius, m: the same as `[design] radius`.
    pub radius: Option<f64>,
    /// Young's modulus, Pa; rigid without it.
    pub modulus: Option<f64>,
    /// Poisson's ratio.
    pub poisson: Option<f64>,
    /// Yield limit, Pa.
    #[serde(rename = "yield")]
    pub yield_limit: Option<f64>,
}

/// `[barrier]`, SI units: the body; its place is `[pendulum] barrier`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BarrierSection {
    /// Young's modulus, Pa: the same as `[design] modulus`.
    pub modulus: Option<f64>,
    /// Poisson's ratio; without it the modulus stands alone, as in the paper.
    pub poisson: Option<f64>,
    /// Yield limit, Pa.
    #[serde(rename = "yield")]
    pub yield_limit: Option<f64>,
}

/// `[[material]]`, SI units: a barrier that a study tries.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialSection {
    /// Its name.
    pub name: String,
    /// Young's modulus, Pa.
    pub modulus: f64,
    /// Poisson's ratio; without it the modulus stands alone, as in the paper.
    pub poisson: Option<f64>,
    /// Yield limit, Pa.
    #[serde(rename = "yield")]
    pub yield_limit: Option<f64>,
    /// Its own damping in equation (7), dimensionless.
    pub mu: Option<f64>,
    /// mu/gamma, dimensionless, in place of mu.
    pub mu_over_gamma: Option<f64>,
    /// The contact damping of Hunt and Crossley, s/m, in place of mu.
    pub lambda: Option<f64>,
    /// The coefficient of restitution, in place of mu.
    pub restitution: Option<f64>,
    /// The speed at which that holds, m/s; without it that of the first touch without damping.
    pub at_speed: Option<f64>,
    /// c of F = (k + c d') d^(3/2), N s/m^(5/2).
    pub damping: Option<f64>,
}

/// `[[wall]]`: a wall, rigid or with a law of contact.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallSection {
    /// The side on which motions are allowed: `"x < d"`.
    pub bound: String,
    /// The coefficient of restitution of a rigid wall: a number, or text such as `"e"`.
    pub restitution: Option<toml::Value>,
    /// The law of a wall that gives way and its quantities: `"hertz K=1e5"`.
    pub contact: Option<String>,
}

/// `[limits]`: what a search for the best design may vary between, in SI units, and what it must
/// keep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LimitsSection {
    /// Lower and upper limit of the mass, kg.
    pub mass: Option<Range>,
    /// Lower and upper limit of the radius of the sphere, m.
    pub radius: Option<Range>,
    /// Lower and upper limit of the length, m.
    pub length: Option<Range>,
    /// Lower and upper limit of the modulus of the barrier, Pa.
    pub modulus: Option<Range>,
    /// The density of the sphere, kg/m^3: its mass is then that of its radius.
    pub density: Option<f64>,
    /// Whether no body with a stated yield limit may yield.
    pub elastic: bool,
    /// The longest rest time, s.
    pub max_rest_time: Option<f64>,
    /// The longest rest time, in units of 1/omega.
    pub max_dimensionless_rest_time: Option<f64>,
    /// The greatest force of a contact, N.
    pub max_peak_force: Option<f64>,
    /// The greatest pressure of a contact, Pa.
    pub max_peak_pressure: Option<f64>,
    /// The most contacts until rest.
    pub max_impacts: Option<f64>,
    /// The longest rest time of the main mass, s.
    pub max_primary_rest_time: Option<f64>,
}

/// `[lower, upper]`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Vec<f64>")]
pub struct Range(pub [f64; 2]);

impl TryFrom<Vec<f64>> for Range {
    type Error = &'static str;

    fn try_from(limits: Vec<f64>) -> Result<Self, &'static str> {
        let limits = <[f64; 2]>::try_from(limits);
        limits.map(Self).map_err(|_| "expected two limits: [lower, upper]")
    }
}

/// `[genetic]`: how a search for the best design goes; the defaults are those of the paper's Table
/// 3 where they can hold together.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GeneticSection {
    /// The objective: one name, or a list of them for a front.
    pub objective: Option<Objectives>,
    /// Individuals.
    pub population: Option<u32>,
    /// Generations after the random population.
    pub generations: Option<u32>,
    /// The best ones, which go on as they are.
    pub elite: Option<u32>,
    /// The part of the others that crossover makes.
    pub crossover_fraction: Option<f64>,
    /// `heuristic`, `scattered` or `one-point`.
    pub crossover: Option<String>,
    /// Extrapolation of a heuristic child beyond the better parent.
    pub crossover_ratio: Option<f64>,
    /// `adaptive-feasible` or `bit-flip`.
    pub mutation: Option<String>,
    /// The probability of a bit to be turned over.
    pub mutation_rate: Option<f64>,
    /// `real` or `bits`.
    pub coding: Option<String>,
    /// Bits of a number.
    pub bits: Option<u32>,
    /// `death`, `feasible-first` or `augmented-lagrangian`.
    pub penalty: Option<String>,
    /// The weight that an augmented Lagrangian begins with.
    pub initial_penalty: Option<f64>,
    /// The factor by which that weight grows.
    pub penalty_factor: Option<f64>,
    /// Largest deviation of the mass from that of the density, relative.
    pub constraint_tolerance: Option<f64>,
    /// Number of generations over which the best value is watched.
    pub stall_generations: Option<u32>,
    /// Change of the best value below which the search ends.
    pub function_tolerance: Option<f64>,
    /// `average` or `weighted`.
    pub stall_test: Option<String>,
    /// Runs.
    pub runs: Option<u32>,
    /// The seed of all random numbers.
    pub seed: Option<u64>,
}

/// One name, or a list of names.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged, expecting = "expected a name in quotes, or a list of them")]
pub enum Objectives {
    /// One.
    One(String),
    /// Several.
    Several(Vec<String>),
}

/// The side of its place on which a barrier is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BarrierSide {
    /// The barrier at smaller angles.
    Left,
    /// The barrier at greater angles.
    Right,
}

/// `false`, where a barrier would be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "bool")]
pub struct NoBarrier;

impl TryFrom<bool> for NoBarrier {
    type Error = &'static str;

    fn try_from(there: bool) -> Result<Self, &'static str> {
        match there {
            false => Ok(Self),
            true => Err("a barrier needs its place"),
        }
    }
}

/// One barrier, on the right unless `side` says otherwise, or one on either side.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(untagged, expecting = "expected a number, or two: [left, right], or false for none")]
pub enum Barrier {
    /// `false`: none at all.
    Absent(NoBarrier),
    /// The position of the only one.
    One(f64),
    /// The positions of both.
    Both([f64; 2]),
}

/// `[primary]`, SI units: the main mass on spring and dashpot that carries the pendulum and its
/// barriers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PrimarySection {
    /// Its mass without the pendulum, kg.
    pub mass: Option<f64>,
    /// The stiffness of its spring, N/m.
    pub stiffness: Option<f64>,
    /// The coefficient of its dashpot, N s/m; none without it.
    pub damping: Option<f64>,
    /// The initial displacement, m.
    pub displacement: Option<f64>,
    /// The initial speed, m/s.
    pub speed: Option<f64>,
    /// The amplitude of a harmonic force on it, N.
    pub force: Option<f64>,
    /// The angular frequency of that force, rad/s.
    pub frequency: Option<f64>,
}

/// `[lagrangian]`: energies as expressions, with `q'` for the velocity of the coordinate `q`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LagrangianSection {
    /// The generalised coordinates, in the order of their equations.
    pub coordinates: Vec<String>,
    /// The kinetic energy.
    pub kinetic: Option<String>,
    /// The potential energy; none without it.
    pub potential: Option<String>,
    /// Rayleigh's dissipation function: `c*x'^2/2` for a dashpot, `F*abs(x')` for dry friction.
    pub dissipation: Option<String>,
    /// The generalised force on each coordinate that has one.
    pub forces: BTreeMap<String, String>,
}

/// `[contact]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Contact {
    /// Dimensionless stiffness; from `[design]` by equation (8) where it is not given.
    pub gamma: Option<f64>,
    /// The whole force of the barrier for `impact`, as an expression in the depth d: `"k*d^2"`.
    pub force: Option<String>,
    /// Dimensionless contact damping of equation (7).
    pub mu: Option<f64>,
    /// Contact damping of Hunt and Crossley, s/m.
    pub lambda: Option<f64>,
    /// mu/gamma, dimensionless, in place of mu.
    pub mu_over_gamma: Option<f64>,
    /// The coefficient of restitution, in place of mu.
    pub restitution: Option<f64>,
    /// The speed at which that holds, in m/s where the file gives any number in SI units (a mass, a
    /// length, a modulus, `lambda`, `viscous` ..), otherwise in units of L omega; without it that
    /// of the first touch without damping.
    pub at_speed: Option<f64>,
    /// c of F = (k + c d') d^(3/2), N s/m^(5/2), in place of mu.
    pub damping: Option<f64>,
    /// The law of the contact in the derived phases of `impact`; `all` for a table of every law.
    pub law: Option<String>,
    /// The rule by which a line replaces the elastic force; `all` for a table of every law of the
    /// contact.
    pub linearisation: Option<String>,
}

/// `[damping]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Damping {
    /// Viscous damping ratio, dimensionless.
    pub zeta: f64,
    /// The coefficient of the viscous force on the bob, N s/m, in place of zeta.
    pub viscous: Option<f64>,
    /// Coulomb friction alpha of equation (7), dimensionless.
    pub alpha: f64,
    /// The torque of that friction, N m, in place of alpha.
    pub torque: Option<f64>,
    /// `exact` or `arctangent`.
    pub friction: Option<String>,
}

/// `[excitation]`
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Excitation {
    /// beta = (A_e/L)(Omega/omega)^2 of a pivot that moves as A_e sin(Omega t), dimensionless.
    pub beta: f64,
    /// Omega/omega, dimensionless.
    pub frequency_ratio: f64,
}

/// `[design]`, SI units; the defaults are the paper's Table 5.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DesignSection {
    /// Mass of the pendulum, kg.
    pub mass: f64,
    /// Radius of the sphere, m.
    pub radius: f64,
    /// Length of the pendulum, m.
    pub length: f64,
    /// Elastic modulus of the barrier, Pa.
    pub modulus: f64,
    /// Acceleration of gravity, m/s^2.
    pub gravity: f64,
}

/// `[run]`
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Run {
    /// Time to follow a motion for, in units of 1/omega.
    pub duration: f64,
    /// Error allowed in one step, relative.
    pub integrator_tolerance: f64,
    /// Steps after which an integration gives up.
    pub step_limit: u32,
}

impl Problem {
    /// Gives a value, as if it stood in `[values]`, but it wins over a key that says the same.
    pub fn set_value(&mut self, name: &str, value: &str) {
        self.overriding.push(name.to_owned());
        self.values.insert(name.to_owned(), toml::Value::String(value.to_owned()));
    }
}

impl Contact {
    /// The damping of the contact in the form in which it is given, the first where there are
    /// several.
    pub fn given_damping(&self) -> Option<ContactDamping> {
        let forms = [self.mu, self.mu_over_gamma, self.lambda, self.restitution, self.damping];
        dampings(forms).first().copied()
    }
}

impl MaterialSection {
    /// The damping of its contact in every form in which it is given: one, or none, where it makes
    /// sense.
    pub fn given_dampings(&self) -> Vec<ContactDamping> {
        dampings([self.mu, self.mu_over_gamma, self.lambda, self.restitution, self.damping])
    }
}

/// The forms that are there, in the order of [`ContactDamping::FORMS`].
fn dampings(values: [Option<f64>; 5]) -> Vec<ContactDamping> {
    let forms = ContactDamping::FORMS.into_iter().zip(values);
    forms.filter_map(|(form, value)| ContactDamping::given(form, value?)).collect()
}

impl Default for Pendulum {
    fn default() -> Self {
        Self {
            amplitude: DEFAULT_AMPLITUDE,
            barrier: Barrier::One(DEFAULT_BARRIER),
            side: None,
            start: None,
            speed: None,
            mass: None,
            length: None,
            gravity: None,
        }
    }
}

impl From<DesignSection> for StiffnessDesign {
    fn from(section: DesignSection) -> Self {
        let DesignSection { mass, radius, length, modulus, gravity } = section;
        Self { mass, radius, length, modulus, gravity }
    }
}

impl Default for DesignSection {
    fn default() -> Self {
        let StiffnessDesign { mass, radius, length, modulus, gravity } = StiffnessDesign::default();
        Self { mass, radius, length, modulus, gravity }
    }
}

impl Default for Run {
    fn default() -> Self {
        Self { duration: 50.0, integrator_tolerance: 1e-10, step_limit: 250_000 }
    }
}

//! Kind `lagrangian`: equations of motion from energies.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::{Map, named, text, texts};
use crate::audit::paper::Finding;
use crate::mechanics::{self, MechanismStudy, RestPosition, RestStudy};

/// A mechanism, its equations of motion by Lagrange, its places of rest and the dimensionless
/// groups on which its motion depends. Formulas are text of the grammar; `q'` is the velocity of
/// `q`. Numbers are in the units of the values that were given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct LagrangianDocument {
    /// The kind of document.
    pub schema: String,
    /// The generalised coordinates, in the order of the equations.
    pub coordinates: Vec<String>,
    /// T, the kinetic energy.
    pub kinetic: String,
    /// V, the potential energy.
    pub potential: String,
    /// D, Rayleigh's dissipation function; `0` where there is none.
    pub dissipation: String,
    /// The generalised force on each coordinate that has one.
    pub forces: Map<String>,
    /// The equations of motion, each `... = 0`.
    pub equations: Vec<String>,
    /// What each was divided by.
    pub divisors: Vec<String>,
    /// The accelerations, solved for.
    pub accelerations: Map<String>,
    /// Whether every term was checked for its unit: only where units were given.
    pub units_checked: bool,
    /// The parameters that give the units of the dimensionless form, and behind them the sizes of
    /// the motion that do, `x0` of the coordinate x, where no product of parameters has its unit;
    /// null without units or where there is none.
    pub units: Option<Vec<String>>,
    /// The sums of parameters that count as one parameter, by their names in what follows; null
    /// likewise.
    pub combinations: Option<Map<String>>,
    /// The unit of time in them; null likewise.
    pub time_unit: Option<String>,
    /// The number of parameters of the equations; null likewise.
    pub parameter_count: Option<usize>,
    /// The rank of the matrix of their dimensions, with those of the sizes that are units; null
    /// likewise.
    pub rank: Option<usize>,
    /// The dimensionless numbers on which the motion depends; null likewise.
    pub groups: Option<Vec<Group>>,
    /// The equations in these units and groups; null likewise.
    pub dimensionless: Option<Vec<String>>,
    /// Why there are no groups; null where there are, and without units.
    pub no_groups: Option<String>,
    /// The values that were given.
    pub values: Map<f64>,
    /// Places of rest that were found; others are not ruled out. Contacts and terms in the time are
    /// left out.
    pub equilibria: Vec<Equilibrium>,
    /// The modes at each of them, in the same order; an empty list where not every parameter has a
    /// value.
    pub modes: Vec<Vec<Mode>>,
    /// The paper's equations beside these; empty for any other mechanism.
    pub findings: Vec<Finding>,
}

/// A dimensionless number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Group {
    /// Its name in `dimensionless`.
    pub name: String,
    /// What it is in the parameters.
    pub definition: String,
    /// The unit of the definition, counted from those of the parameters: `1`.
    pub dimension: String,
    /// What it does.
    pub meaning: String,
}

/// A place of rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Equilibrium {
    /// The place of each coordinate; null for one that may be anywhere.
    pub places: Map<Option<String>>,
    /// What lies between -1 and 1 where the place exists; null where it always does.
    pub cosine: Option<String>,
    /// omega^2 of small swings about it, negative where it is unstable; null for several
    /// coordinates, and where the linear equation changes with the time other than by sines and
    /// cosines of it.
    pub frequency_squared: Option<String>,
}

/// A mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Mode {
    /// Angular frequency; 0 where it does not swing.
    pub frequency: f64,
    /// The exponent of growth, negative for decay, per unit of time.
    pub growth: f64,
    /// The coordinates in proportion, the largest 1; null where damping makes them move out of
    /// step.
    pub shape: Option<Vec<f64>>,
}

/// The document of kind `lagrangian`; the paper's equations are put into it as its `findings`.
///
/// ```
/// use lindstedt::{audit::paper, mechanics::study};
///
/// let study = study(paper::mechanism())?;
/// let document = lindstedt::export::json::lagrangian(&study);
/// assert_eq!(document.groups.map(|groups| groups.len()), Some(7));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn lagrangian(study: &MechanismStudy) -> LagrangianDocument {
    let mechanism = &study.question.mechanism;
    let coordinates = &mechanism.coordinates;
    let groups = study.groups.as_ref().and_then(|groups| groups.as_ref().ok());
    let zero = |left: &crate::expr::Expr| format!("{left} = 0");
    let accelerations = study.equations.accelerations().unwrap_or_default();
    let equilibrium = |rest: &RestStudy| {
        let place = |place: &RestPosition| match place {
            RestPosition::At(place) => Some(place.to_string()),
            RestPosition::Anywhere => None,
        };
        let places = rest.rest.places.iter().map(place);
        Equilibrium {
            places: named(coordinates.iter().zip(places)),
            cosine: text(rest.rest.condition.as_ref()),
            frequency_squared: text(rest.modes.square().ok().flatten()),
        }
    };
    let modes = |rest: &RestStudy| {
        let known = rest.numbers.as_ref().and_then(|numbers| numbers.as_ref().ok());
        let mode = |mode: &mechanics::Mode| Mode {
            frequency: mode.frequency,
            growth: mode.growth,
            shape: mode.shape.clone(),
        };
        known.map(|modes| modes.iter().map(mode).collect()).unwrap_or_default()
    };
    LagrangianDocument {
        schema: DocumentKind::Lagrangian.schema().to_owned(),
        coordinates: texts(coordinates),
        kinetic: mechanism.kinetic.to_string(),
        potential: mechanism.potential.to_string(),
        dissipation: mechanism.dissipation.to_string(),
        forces: named(mechanism.forces.iter().map(|(on, force)| (on, force.to_string()))),
        equations: study.equations.left.iter().map(zero).collect(),
        divisors: texts(&study.equations.divisors),
        accelerations: named(coordinates.iter().zip(texts(&accelerations))),
        units_checked: study.question.units.is_some(),
        units: groups.map(|groups| texts(&groups.units)),
        combinations: groups.map(|groups| {
            let combinations = groups.combinations.iter();
            named(combinations.map(|own| (own.name, own.meaning.to_string())))
        }),
        time_unit: groups.map(|groups| groups.time.to_string()),
        parameter_count: groups.map(|groups| groups.parameters),
        rank: groups.map(|groups| groups.rank),
        groups: groups.map(|groups| groups.groups.iter().map(group).collect()),
        dimensionless: groups.map(|groups| groups.left.iter().map(zero).collect()),
        no_groups: text(study.groups.as_ref().and_then(|groups| groups.as_ref().err())),
        values: named(study.question.values.iter().map(|(name, value)| (name, *value))),
        equilibria: study.rests.iter().map(equilibrium).collect(),
        modes: study.rests.iter().map(modes).collect(),
        findings: Vec::new(),
    }
}

fn group(group: &mechanics::Group) -> Group {
    Group {
        name: group.name.to_string(),
        definition: group.definition.to_string(),
        dimension: group.dimension.to_string(),
        meaning: group.meaning.clone(),
    }
}

//! Kind `orbits`: periodic impact orbits.

use num_complex::Complex64;
#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::{Constant, Map, constants, finite, meanings};
use crate::orbits::{
    FoundOrbits, JudgedImpactOrbit, OrbitChart, OrbitFamily, OrbitLaws, OrbitRelation,
    OrbitStability, OrbitSweep, VaryingParameter,
};
use crate::report::{OrbitsReport, obstacle_in_words};
use crate::values::Values;

/// Periodic motions that are linear between impacts on rigid walls.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct OrbitsDocument {
    /// The kind of document.
    pub schema: String,
    /// The left side of the equation of motion, zero on the right.
    pub equation: String,
    /// The coordinate.
    pub coordinate: String,
    /// The walls.
    pub walls: Vec<OrbitWallDocument>,
    /// The laws in letters, one for each wall, before them that of symmetric orbits between two walls
    /// placed alike.
    pub laws: Vec<OrbitLawsDocument>,
    /// The values; null without them.
    pub at: Option<Map<Constant>>,
    /// The orbits at these values, fewer periods first, then the faster; null without values, and of
    /// a sweep or a chart.
    pub orbits: Option<Vec<OrbitDocument>>,
    /// Numbers of periods in whose time the free motion returns to itself, so that there is no orbit;
    /// null likewise.
    pub degenerate_periods: Option<Vec<u32>>,
    /// The orbits along a parameter; null without one.
    pub sweep: Option<OrbitSweepDocument>,
    /// The orbits over two parameters; null without them.
    pub chart: Option<OrbitChartDocument>,
    /// Whether a simulation returns to every orbit that motions follow, `pass` or `fail`; null where
    /// there is none, and without values.
    pub verdict: Option<String>,
    /// The largest error that passes; null without orbits.
    pub tolerance: Option<f64>,
}

/// A rigid wall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OrbitWall"))]
pub struct OrbitWallDocument {
    /// The gap: positive where motions are allowed.
    pub gap: String,
    /// The coefficient of restitution.
    pub restitution: String,
}

/// The laws of orbits in letters. The speed is that relative to the wall, just before the impact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OrbitLaws"))]
pub struct OrbitLawsDocument {
    /// The orbits: `one-impact`, or `symmetric` with one impact on each of two walls.
    pub kind: String,
    /// The number of the wall, from 1.
    pub wall: usize,
    /// The letter of the gap.
    pub gap: String,
    /// The equation of the gap between impacts.
    pub gap_equation: String,
    /// The symbols that shorten the formulas, each of those before it.
    pub definitions: Map<String>,
    /// Speed, phase, trace, determinant and multipliers.
    pub relations: Vec<OrbitRelationDocument>,
    /// The curves in the parameters at which the orbits change.
    pub curves: Vec<OrbitRelationDocument>,
    /// Conventions, and where the formulas hold.
    pub validity: Vec<String>,
}

/// An equation of an orbit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OrbitRelation"))]
pub struct OrbitRelationDocument {
    /// The name: `speed`, `phase`, `wave-velocity`, `wave-position`, `trace`, `determinant`,
    /// `multipliers`; of a curve `grazing`, `fold`, `period-doubling`, `symmetry-breaking`.
    pub name: String,
    /// The equation.
    pub equation: String,
    /// The equation in words.
    pub words: String,
}

/// An orbit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "Orbit"))]
pub struct OrbitDocument {
    /// The way it was found: `one-impact` or `symmetric` in closed form, or `searched`.
    pub kind: String,
    /// The number of impacts in its period.
    pub impacts: usize,
    /// The number of periods of the drive in its period.
    pub periods: u32,
    /// The number of the wall of each impact, from 1.
    pub walls: Vec<usize>,
    /// The time of each impact, as in the equation.
    pub times: Vec<f64>,
    /// The phase of the drive at each impact, from 0 to 2 pi.
    pub phases: Vec<f64>,
    /// The speed of each impact, relative to the wall, just before it.
    pub speeds: Vec<f64>,
    /// The Floquet multipliers over its period.
    pub multipliers: Vec<MultiplierDocument>,
    /// Whether all multipliers lie within the unit circle.
    pub stable: bool,
    /// `stable`, `marginal` with a multiplier on the unit circle, or `unstable`.
    pub stability: String,
    /// Whether a motion follows it: between impacts it is beyond no wall.
    pub admissible: bool,
    /// Why no motion follows it; null of one that motions follow.
    pub reason: Option<String>,
    /// The distance of a simulation from its start after a period of the orbit, over the impact speed;
    /// null where none was followed.
    pub return_error: Option<f64>,
    /// The multipliers of the simulation; null likewise.
    pub simulated_multipliers: Option<Vec<MultiplierDocument>>,
    /// The verdict of the simulation, `pass` or `fail`; null likewise.
    pub verdict: Option<String>,
}

/// A Floquet multiplier.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OrbitMultiplier"))]
pub struct MultiplierDocument {
    /// The real part.
    pub re: f64,
    /// The imaginary part.
    pub im: f64,
}

/// Orbits along a parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OrbitSweep"))]
pub struct OrbitSweepDocument {
    /// The parameter.
    pub parameter: String,
    /// The beginning and the end of its range.
    pub range: [f64; 2],
    /// The branches.
    pub branches: Vec<OrbitBranchDocument>,
    /// The places where orbits change, in order of the parameter.
    pub changes: Vec<OrbitChangeDocument>,
}

/// Orbits of one kind along the parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OrbitBranch"))]
pub struct OrbitBranchDocument {
    /// `one-impact` or `symmetric`.
    pub kind: String,
    /// The number of the wall, from 1.
    pub wall: usize,
    /// The number of periods of the drive.
    pub periods: u32,
    /// The parameter of each orbit.
    pub parameters: Vec<f64>,
    /// The speed just before the impact of each.
    pub speeds: Vec<f64>,
    /// The phase of the drive at the impact of each.
    pub phases: Vec<f64>,
    /// Whether each is stable.
    pub stable: Vec<bool>,
    /// Whether a motion follows each.
    pub admissible: Vec<bool>,
}

/// A place where orbits change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OrbitChange"))]
pub struct OrbitChangeDocument {
    /// `grazing`, `fold`, `period-doubling`, `symmetry-breaking`, or `second-impact`, where an orbit touches a wall between impacts.
    pub kind: String,
    /// The number of the wall, from 1.
    pub wall: usize,
    /// The number of periods of the drive of the orbit.
    pub periods: u32,
    /// The parameter.
    pub parameter: f64,
    /// The speed there; null of grazing.
    pub speed: Option<f64>,
}

/// Orbits over two parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OrbitChart"))]
pub struct OrbitChartDocument {
    /// The parameter across.
    pub across: String,
    /// The beginning and the end of its range.
    pub across_range: [f64; 2],
    /// The parameter upwards.
    pub upwards: String,
    /// The beginning and the end of its range.
    pub upwards_range: [f64; 2],
    /// Points in a row, which lie equally far from one end of its range to the other.
    pub columns: usize,
    /// Rows, likewise.
    pub rows: usize,
    /// The kinds of orbits.
    pub families: Vec<OrbitFamilyDocument>,
    /// The curves at which orbits change.
    pub curves: Vec<OrbitCurveDocument>,
}

/// Orbits of one kind in a chart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OrbitFamily"))]
pub struct OrbitFamilyDocument {
    /// `one-impact` or `symmetric`.
    pub kind: String,
    /// The number of the wall, from 1.
    pub wall: usize,
    /// The number of periods of the drive.
    pub periods: u32,
    /// A text for each row, from below, a digit for each point: the number of orbits that motions
    /// follow.
    pub orbits: Vec<String>,
    /// The number of stable ones among them, likewise.
    pub stable: Vec<String>,
}

/// A curve of a chart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OrbitCurve"))]
pub struct OrbitCurveDocument {
    /// `grazing`, `fold`, `period-doubling`, `symmetry-breaking`, or `second-impact`, where an orbit touches a wall between impacts.
    pub kind: String,
    /// The number of the wall, from 1.
    pub wall: usize,
    /// The number of periods of the drive of the orbit.
    pub periods: u32,
    /// The pieces of the curve: of each its points, across and upwards.
    pub pieces: Vec<Vec<[f64; 2]>>,
}

/// The document of kind `orbits`.
///
/// ```
/// use lindstedt::orbits::{ImpactEquation, laws};
/// use lindstedt::report::OrbitsReport;
/// use lindstedt::{Oscillator, wall::Wall};
///
/// let ball = Oscillator::parse("x'' + g = 0")?;
/// let table = Wall::parse("x > Z*sin(w*t)", &"e".parse()?)?;
/// let question = ImpactEquation::new(&ball, &table)?;
/// let laws = laws(&question)?;
/// let report =
///     OrbitsReport { question: &question, laws: &laws, found: None, sweep: None, chart: None };
/// let document = lindstedt::export::json::orbits(&report);
/// assert_eq!(document.laws[0].relations[0].equation, "v = g*T/(1 + e)");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn orbits(report: &OrbitsReport) -> OrbitsDocument {
    let question = report.question;
    let walls = question.walls.iter().map(|own| OrbitWallDocument {
        gap: own.wall.gap.to_string(),
        restitution: own.wall.restitution.to_string(),
    });
    let found = report.found;
    let values: Option<&Values> = found
        .map(|own| &own.at)
        .or(report.sweep.map(|own| &own.at))
        .or(report.chart.map(|own| &own.at));
    OrbitsDocument {
        schema: DocumentKind::Orbits.schema().to_owned(),
        equation: question.oscillator.equation().left.to_string(),
        coordinate: question.oscillator.coordinate.to_string(),
        walls: walls.collect(),
        laws: report.laws.iter().map(laws).collect(),
        at: values.map(constants),
        orbits: found.map(|found| found.orbits.iter().map(|own| orbit(report, own)).collect()),
        degenerate_periods: found.map(|found| found.degenerate.clone()),
        sweep: report.sweep.map(sweep),
        chart: report.chart.map(chart),
        verdict: found.and_then(|found: &FoundOrbits| Some(found.verdict?.name().to_owned())),
        tolerance: found.map(|found| found.tolerance),
    }
}

fn laws(laws: &OrbitLaws) -> OrbitLawsDocument {
    let relation = |own: &OrbitRelation| OrbitRelationDocument {
        name: own.name.to_owned(),
        equation: format!("{} = {}", own.left, own.right),
        words: own.words.to_owned(),
    };
    let [left, right] = &laws.equation;
    OrbitLawsDocument {
        kind: laws.kind.name().to_owned(),
        wall: laws.wall + 1,
        gap: laws.gap.symbol.to_string(),
        gap_equation: format!("{left} = {right}"),
        definitions: meanings(&laws.definitions),
        relations: laws.relations.iter().map(relation).collect(),
        curves: laws.curves.iter().map(relation).collect(),
        validity: laws.validity.clone(),
    }
}

fn pair(multipliers: &[Complex64; 2]) -> Vec<MultiplierDocument> {
    multipliers.iter().map(|own| MultiplierDocument { re: own.re, im: own.im }).collect()
}

fn orbit(report: &OrbitsReport, judged: &JudgedImpactOrbit) -> OrbitDocument {
    let own = &judged.orbit;
    let verdict = judged.verdict.as_ref();
    OrbitDocument {
        kind: own.kind.name().to_owned(),
        impacts: own.impacts.len(),
        periods: own.periods,
        walls: own.impacts.iter().map(|impact| impact.wall + 1).collect(),
        times: own.impacts.iter().map(|impact| impact.time).collect(),
        phases: own.impacts.iter().map(|impact| impact.phase).collect(),
        speeds: own.impacts.iter().map(|impact| impact.speed).collect(),
        multipliers: pair(&own.multipliers),
        stable: own.stability == OrbitStability::Stable,
        stability: own.stability.name().to_owned(),
        admissible: own.is_admissible(),
        reason: obstacle_in_words(report.question, own),
        return_error: finite(verdict.map(|own| own.return_error)),
        simulated_multipliers: verdict.and_then(|own| own.multipliers.as_ref().map(pair)),
        verdict: verdict.map(|own| own.verdict.name().to_owned()),
    }
}

fn range(vary: VaryingParameter) -> (String, [f64; 2]) {
    (vary.name.to_string(), vary.range)
}

fn sweep(sweep: &OrbitSweep) -> OrbitSweepDocument {
    let (parameter, range) = range(sweep.vary);
    let branches = sweep.branches.iter().map(|branch| OrbitBranchDocument {
        kind: branch.family.kind.name().to_owned(),
        wall: branch.family.wall + 1,
        periods: branch.family.periods,
        parameters: branch.points.iter().map(|own| own.parameter).collect(),
        speeds: branch.points.iter().map(|own| own.speed).collect(),
        phases: branch.points.iter().map(|own| own.phase).collect(),
        stable: branch.points.iter().map(|own| own.stability == OrbitStability::Stable).collect(),
        admissible: branch.points.iter().map(|own| own.admissible).collect(),
    });
    let changes = sweep.changes.iter().map(|own| OrbitChangeDocument {
        kind: own.change.name().to_owned(),
        wall: own.family.wall + 1,
        periods: own.family.periods,
        parameter: own.parameter,
        speed: own.speed,
    });
    OrbitSweepDocument {
        parameter,
        range,
        branches: branches.collect(),
        changes: changes.collect(),
    }
}

fn chart(chart: &OrbitChart) -> OrbitChartDocument {
    let [columns, rows] = chart.size;
    let digits = |of: &dyn Fn(usize) -> u8| -> Vec<String> {
        let row = |row: usize| {
            (0..columns)
                .map(|column| char::from(b'0' + of(row * columns + column).min(9)))
                .collect()
        };
        (0..rows).map(row).collect()
    };
    let families =
        chart.families.iter().enumerate().map(|(index, family): (usize, &OrbitFamily)| {
            OrbitFamilyDocument {
                kind: family.kind.name().to_owned(),
                wall: family.wall + 1,
                periods: family.periods,
                orbits: digits(&|at| chart.points[at].orbits[index]),
                stable: digits(&|at| chart.points[at].stable[index]),
            }
        });
    let curves = chart.curves.iter().map(|own| OrbitCurveDocument {
        kind: own.change.name().to_owned(),
        wall: own.family.wall + 1,
        periods: own.family.periods,
        pieces: own.pieces.clone(),
    });
    let (across, across_range) = range(chart.across);
    let (upwards, upwards_range) = range(chart.upwards);
    OrbitChartDocument {
        across,
        across_range,
        upwards,
        upwards_range,
        columns,
        rows,
        families: families.collect(),
        curves: curves.collect(),
    }
}

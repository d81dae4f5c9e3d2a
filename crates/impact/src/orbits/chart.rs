//! Charts over two parameters: where orbits in closed form exist and are stable, with the curves at
//! which they change.

use super::OrbitRequest;
use super::contour::zero_curves;
use super::equation::{CompiledImpact, ImpactEquation, ImpactNumbers};
use super::error::OrbitError;
use super::family::{OrbitChange, OrbitFamily};
use super::multipliers::OrbitStability;
use super::one_impact::{ImpactState, OneImpact};
use super::sweep::{VaryingParameter, check_periods};
use crate::numeric::ode::root::{BisectionStop, bisect};
use crate::parallel::par_map;
use crate::values::Values;

/// A chart of orbits.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitChart {
    /// The parameter across.
    pub across: VaryingParameter,
    /// The parameter upwards.
    pub upwards: VaryingParameter,
    /// The other values.
    pub at: Values,
    /// The families of orbits.
    pub families: Vec<OrbitFamily>,
    /// Points in a row, and rows.
    pub size: [usize; 2],
    /// The points, row by row from below.
    pub points: Vec<ChartPoint>,
    /// The curves.
    pub curves: Vec<OrbitCurve>,
}

/// The orbits at a point of a chart; only those that a motion follows count.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChartPoint {
    /// The number of orbits of each family, in the order of [`OrbitChart::families`].
    pub orbits: Vec<u8>,
    /// The number of stable ones among them.
    pub stable: Vec<u8>,
}

/// A curve of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitCurve {
    /// The change of the orbits on it.
    pub change: OrbitChange,
    /// The family of orbits that changes.
    pub family: OrbitFamily,
    /// The curve in pieces: points across and upwards.
    pub pieces: Vec<Vec<[f64; 2]>>,
}

impl OrbitChart {
    /// The values of both parameters at a point.
    pub fn place(&self, index: usize) -> [f64; 2] {
        let [columns, rows] = self.size;
        [self.across.value(index % columns, columns), self.upwards.value(index / columns, rows)]
    }
}

/// Points in a row and rows of a chart.
pub const CHART_SIZE: usize = 200;

/// Computes a chart of so many points in each direction.
///
/// # Errors
/// [`OrbitError`]: a missing or unknown value, a parameter with a value, a frequency that is not
/// positive somewhere.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::{Oscillator, wall::Wall};
/// use lindstedt::orbits::{ImpactEquation, OrbitRequest, VaryingParameter, chart_orbits};
///
/// let beam = Oscillator::parse("x'' + x'/10 + x = F*cos(w*t)")?;
/// let question = ImpactEquation::new(&beam, &Wall::parse("x < 1", &"0.8".parse()?)?)?;
/// let parameters = [("w", [0.5, 3.0]), ("F", [0.05, 1.5])];
/// let parameters = parameters.map(|(name, range)| VaryingParameter { name: name.into(), range });
/// let chart = chart_orbits(&question, &"".parse()?, parameters, 40, &OrbitRequest::default())?;
/// assert!(chart.points.iter().any(|point| point.stable[0] == 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn chart_orbits(
    question: &ImpactEquation,
    values: &Values,
    [across, upwards]: [VaryingParameter; 2],
    size: usize,
    request: &OrbitRequest,
) -> Result<OrbitChart, OrbitError> {
    across.check()?;
    upwards.check()?;
    check_periods(request.periods)?;
    if across.name == upwards.name {
        return Err(OrbitError::Given(across.name));
    }
    let size = size.max(2);
    let compiled = question.compile(values, &[across.name, upwards.name])?;
    question.check_restitution(values, &[across, upwards])?;
    let families = OrbitFamily::all(question, request.periods)?;
    let mut chart = OrbitChart {
        across,
        upwards,
        at: values.clone(),
        families,
        size: [size, size],
        points: vec![],
        curves: vec![],
    };
    // Every corner first: a frequency out of range is refused before any work.
    for index in [0, size - 1, size * (size - 1), size * size - 1] {
        compiled.at(&chart.place(index))?;
    }
    let rows: Vec<usize> = (0..size).collect();
    let rows = par_map(&rows, |row| {
        let places = (0..size).map(|column| chart.place(row * size + column));
        places.map(|place| look(&compiled, &chart.families, place)).collect::<Vec<_>>()
    });
    if request.interrupt.is_requested() {
        return Err(OrbitError::Interrupted);
    }
    let (points, measures): (Vec<ChartPoint>, Vec<Vec<Measures>>) =
        rows.into_iter().flatten().unzip();
    chart.points = points;
    chart.curves = curves(&compiled, &chart, &measures);
    Ok(chart)
}

/// Quantities of a family that are zero where its orbits change, by the index of [`measure`].
type Measures = [f64; 6];

/// A quantity that is zero where orbits change, NaN where it has no meaning: 0 grazing, 1 the fold; of
/// the faster and of the slower orbit 2 and 3 the multiplier -1, then 4 and 5 whether a motion follows
/// the orbit, 1, or not, -1.
fn measure(
    family: OrbitFamily,
    numbers: &ImpactNumbers,
    (relation, states): (&OneImpact, &[Option<ImpactState>; 2]),
    index: usize,
) -> f64 {
    let of_state = |index: usize, measure: &dyn Fn(&ImpactState) -> f64| {
        states[index].as_ref().map_or(f64::NAN, measure)
    };
    match index {
        0 => relation.grazing().unwrap_or(f64::NAN),
        1 => relation.fold(),
        2 | 3 => of_state(index - 2, &|state| relation.period_doubling(state)),
        index => of_state(index - 4, &|state| {
            if family.is_admissible(numbers, relation, state) { 1.0 } else { -1.0 }
        }),
    }
}

/// The orbits at a place.
fn look(
    compiled: &CompiledImpact,
    families: &[OrbitFamily],
    place: [f64; 2],
) -> (ChartPoint, Vec<Measures>) {
    let mut point = ChartPoint::default();
    let numbers = compiled.at(&place).ok();
    let measures = families.iter().map(|family| {
        let own = numbers.as_ref().and_then(|numbers| Some((numbers, family.relation(numbers)?)));
        let (mut orbits, mut stable) = (0, 0);
        let measures = own.as_ref().map_or([f64::NAN; 6], |(numbers, relation)| {
            let states = relation.states();
            let measures: Measures =
                std::array::from_fn(|index| measure(*family, numbers, (relation, &states), index));
            for (state, admissible) in states.iter().zip(&measures[4..]) {
                if let Some(state) = state.as_ref().filter(|_| *admissible > 0.0) {
                    orbits += 1;
                    stable += u8::from(family.stability(relation, state) == OrbitStability::Stable);
                }
            }
            measures
        });
        point.orbits.push(orbits);
        point.stable.push(stable);
        measures
    });
    let measures = measures.collect();
    (point, measures)
}

/// The curves of all families.
fn curves(
    compiled: &CompiledImpact,
    chart: &OrbitChart,
    measures: &[Vec<Measures>],
) -> Vec<OrbitCurve> {
    let [columns, _] = chart.size;
    let mut curves: Vec<OrbitCurve> = Vec::new();
    for (number, family) in chart.families.iter().enumerate() {
        for index in 0..measures[0][number].len() {
            let change = match index {
                0 => OrbitChange::Grazing,
                1 => OrbitChange::Fold,
                2 | 3 => OrbitChange::of_minus_one(family.kind),
                _ => OrbitChange::SecondImpact,
            };
            // Without impacts there are no periods: grazing is one curve for each wall.
            let is_known =
                |curve: &OrbitCurve| curve.change == change && curve.family.wall == family.wall;
            if change == OrbitChange::Grazing && curves.iter().any(is_known) {
                continue;
            }
            let values: Vec<f64> = measures.iter().map(|own| own[number][index]).collect();
            let zero = |[column, row]: [usize; 2], [right, upper]: [usize; 2]| {
                let from = chart.place(row * columns + column);
                let to = chart.place(upper * columns + right);
                crossing(compiled, *family, index, [from, to])
            };
            let pieces = zero_curves(&values, columns, zero);
            if !pieces.is_empty() {
                curves.push(OrbitCurve { change, family: *family, pieces });
            }
        }
    }
    curves
}

/// The place between two where a measure is zero; `None` if it passes through a pole there, or no
/// motion follows the orbit that changes.
fn crossing(
    compiled: &CompiledImpact,
    family: OrbitFamily,
    index: usize,
    [from, to]: [[f64; 2]; 2],
) -> Option<[f64; 2]> {
    const HALVINGS: u32 = 30;
    let place = |part: f64| [0, 1].map(|at| from[at] * (1.0 - part) + to[at] * part);
    let relation = |part: f64| -> Option<(ImpactNumbers, OneImpact)> {
        let numbers = compiled.at(&place(part)).ok()?;
        let relation = family.relation(&numbers)?;
        Some((numbers, relation))
    };
    let at = |part: f64| {
        relation(part).map_or(f64::NAN, |(numbers, own)| {
            measure(family, &numbers, (&own, &own.states()), index)
        })
    };
    let (first, last) = (at(0.0), at(1.0));
    let holds = |part: f64| (at(part) > 0.0) == (first > 0.0);
    let [inside, outside] = bisect(holds, 0.0, 1.0, BisectionStop::Halvings(HALVINGS));
    let scale = first.abs().max(last.abs());
    let size = |part: f64| at(part).abs();
    // Whether a motion follows an orbit has no small values, and is decided on both sides.
    let is_decided = index >= 4;
    let is_zero = size(inside).min(size(outside)) <= 1e-3 * scale;
    if !is_decided && !is_zero {
        return None;
    }
    if index > 0 && !is_decided {
        // A fold has orbits on one side alone.
        let is_followed = [inside, outside].into_iter().any(|part| {
            relation(part).is_some_and(|(numbers, relation)| {
                let states = relation.states();
                let state = match index {
                    1 => states[0],
                    index => states[index - 2],
                };
                state.is_some_and(|state| family.is_admissible(&numbers, &relation, &state))
            })
        });
        if !is_followed {
            return None;
        }
    }
    Some(place(inside))
}

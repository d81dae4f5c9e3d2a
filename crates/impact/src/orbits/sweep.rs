//! Orbits in closed form along a parameter: speeds, phases, stability, and where they change.

use super::equation::{ImpactEquation, ImpactNumbers};
use super::error::OrbitError;
use super::family::{OrbitChange, OrbitFamily};
use super::multipliers::OrbitStability;
use super::one_impact::OneImpact;
use super::{MOST_PERIODS, OrbitRequest};
use crate::numeric::ode::root::{BisectionStop, bisect};
use crate::symbol::Symbol;
use crate::values::Values;

/// A parameter that varies, and its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VaryingParameter {
    /// The parameter.
    pub name: Symbol,
    /// The beginning and the end of its range.
    pub range: [f64; 2],
}

impl VaryingParameter {
    /// The value of a step of so many.
    pub(super) fn value(&self, step: usize, steps: usize) -> f64 {
        let part = step as f64 / (steps - 1) as f64;
        self.range[0] * (1.0 - part) + self.range[1] * part
    }

    pub(super) fn check(&self) -> Result<(), OrbitError> {
        let [from, to] = self.range;
        match from.is_finite() && to.is_finite() && from != to {
            true => Ok(()),
            false => Err(OrbitError::Range(self.name)),
        }
    }
}

/// An orbit of a branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BranchPoint {
    /// The parameter.
    pub parameter: f64,
    /// The speed just before the impact.
    pub speed: f64,
    /// The phase of the drive at the impact.
    pub phase: f64,
    /// The stability.
    pub stability: OrbitStability,
    /// Whether a motion follows it.
    pub admissible: bool,
}

/// Orbits of one family along the parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitBranch {
    /// The family.
    pub family: OrbitFamily,
    /// Whether these are the faster of the two orbits; of two with one speed, of the first phase.
    pub faster: bool,
    /// The orbits, in order of the parameter; where there is none a branch ends.
    pub points: Vec<BranchPoint>,
}

/// A place where orbits change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitChangePoint {
    /// The kind of change.
    pub change: OrbitChange,
    /// The family of orbits.
    pub family: OrbitFamily,
    /// The parameter.
    pub parameter: f64,
    /// The speed there; `None` of grazing.
    pub speed: Option<f64>,
}

/// Orbits along a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitSweep {
    /// The parameter.
    pub vary: VaryingParameter,
    /// The other values.
    pub at: Values,
    /// The branches.
    pub branches: Vec<OrbitBranch>,
    /// The places where orbits change, in order of the parameter.
    pub changes: Vec<OrbitChangePoint>,
}

/// Values of the parameter at which orbits are computed.
const STEPS: usize = 601;

/// Follows the orbits in closed form along a parameter.
///
/// # Errors
/// [`OrbitError`]: a missing or unknown value, a parameter with a value, a frequency that is not
/// positive somewhere.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::{Oscillator, wall::Wall};
/// use lindstedt::orbits::{ImpactEquation, OrbitChange, OrbitRequest, VaryingParameter, sweep_orbits};
///
/// let beam = Oscillator::parse("x'' + x'/10 + x = F*cos(t)")?;
/// let question = ImpactEquation::new(&beam, &Wall::parse("x < 1", &"0.8".parse()?)?)?;
/// let vary = VaryingParameter { name: "F".into(), range: [0.05, 1.0] };
/// let sweep = sweep_orbits(&question, &"".parse()?, vary, &OrbitRequest::default())?;
/// let grazing = sweep.changes.iter().find(|own| own.change == OrbitChange::Grazing).expect("one");
/// assert!((grazing.parameter - 0.1).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep_orbits(
    question: &ImpactEquation,
    values: &Values,
    vary: VaryingParameter,
    request: &OrbitRequest,
) -> Result<OrbitSweep, OrbitError> {
    vary.check()?;
    check_periods(request.periods)?;
    let compiled = question.compile(values, &[vary.name])?;
    question.check_restitution(values, &[vary])?;
    let families = OrbitFamily::all(question, request.periods)?;
    for step in 0..STEPS {
        compiled.at(&[vary.value(step, STEPS)])?;
    }
    let (mut branches, mut changes) = (Vec::new(), Vec::new());
    for family in families {
        if request.interrupt.is_requested() {
            return Err(OrbitError::Interrupted);
        }
        let look = |parameter: f64| {
            let numbers = compiled.at(&[parameter]).ok()?;
            let relation = family.relation(&numbers)?;
            Some((numbers, relation))
        };
        let mut open: [Option<OrbitBranch>; 2] = [None, None];
        let mut before: Option<(f64, Look)> = None;
        for step in 0..STEPS {
            let parameter = vary.value(step, STEPS);
            let Some(own) = look(parameter) else {
                branches.extend(open.iter_mut().filter_map(Option::take));
                before = None;
                continue;
            };
            let (numbers, relation) = &own;
            for (index, state) in relation.states().into_iter().enumerate() {
                let Some(state) = state else {
                    branches.extend(open[index].take());
                    continue;
                };
                let point = BranchPoint {
                    parameter,
                    speed: state.speed,
                    phase: state.phase,
                    stability: family.stability(relation, &state),
                    admissible: family.is_admissible(numbers, relation, &state),
                };
                let branch = || OrbitBranch { family, faster: index == 0, points: vec![] };
                open[index].get_or_insert_with(branch).points.push(point);
            }
            if let Some((from, earlier)) = &before {
                let ends = [(*from, earlier), (parameter, &own)];
                changes_between(family, ends, &look, &mut changes);
            }
            before = Some((parameter, own));
        }
        branches.extend(open.into_iter().flatten());
    }
    changes.sort_by(|a, b| a.parameter.total_cmp(&b.parameter));
    // Grazing is one for all numbers of periods.
    changes.dedup_by(|a, b| {
        a.change == OrbitChange::Grazing
            && b.change == a.change
            && a.family.wall == b.family.wall
            && (a.parameter - b.parameter).abs() <= 1e-12 * a.parameter.abs()
    });
    Ok(OrbitSweep { vary, at: values.clone(), branches, changes })
}

/// The numbers of periods within their range.
pub(super) fn check_periods(periods: [u32; 2]) -> Result<(), OrbitError> {
    match periods.into_iter().find(|value| !(1..=MOST_PERIODS).contains(value)) {
        Some(value) => Err(OrbitError::Count { what: "the periods", value, most: MOST_PERIODS }),
        None => Ok(()),
    }
}

/// The numbers at a value of the parameter and the relation of the orbits there.
type Look = (ImpactNumbers, OneImpact);

/// A measure that changes its sign where orbits change; `None` where it has no meaning.
type Measure<'a> = &'a dyn Fn(&Look) -> Option<f64>;

/// Adds the changes between two values of the parameter.
fn changes_between(
    family: OrbitFamily,
    [from, to]: [(f64, &Look); 2],
    look: &impl Fn(f64) -> Option<Look>,
    changes: &mut Vec<OrbitChangePoint>,
) {
    let mut add = |change: OrbitChange, measure: Measure, orbit: usize| {
        let Some([inside, outside]) = sign_change(change, measure, [from, to], look) else {
            return;
        };
        let there = [inside, outside].into_iter().find_map(|parameter| {
            let (numbers, relation) = look(parameter)?;
            let state = relation.states()[orbit]?;
            family.is_admissible(&numbers, &relation, &state).then_some((parameter, state.speed))
        });
        let found = match (change, there) {
            (OrbitChange::Grazing, _) => Some((inside, None)),
            (_, Some((parameter, speed))) => Some((parameter, Some(speed))),
            // No motion follows the orbit that changes.
            (_, None) => None,
        };
        changes.extend(found.map(|(parameter, speed)| OrbitChangePoint {
            change,
            family,
            parameter,
            speed,
        }));
    };
    add(OrbitChange::Grazing, &|(_, relation)| relation.grazing(), 0);
    add(OrbitChange::Fold, &|(_, relation)| Some(relation.fold()), 0);
    for orbit in 0..2 {
        let minus_one = move |(_, relation): &Look| {
            relation.states()[orbit].map(|state| relation.period_doubling(&state))
        };
        add(OrbitChange::of_minus_one(family.kind), &minus_one, orbit);
        let follows = move |(numbers, relation): &Look| {
            let state = relation.states()[orbit]?;
            Some(if family.is_admissible(numbers, relation, &state) { 1.0 } else { -1.0 })
        };
        add(OrbitChange::SecondImpact, &follows, orbit);
    }
}

/// The neighbouring values of the parameter between which a measure changes its sign.
fn sign_change(
    change: OrbitChange,
    measure: Measure,
    [(from, earlier), (to, later)]: [(f64, &Look); 2],
    look: &impl Fn(f64) -> Option<Look>,
) -> Option<[f64; 2]> {
    let (first, last) = (measure(earlier)?, measure(later)?);
    if (first > 0.0) == (last > 0.0) {
        return None;
    }
    let value = |parameter: f64| look(parameter).and_then(|own| measure(&own));
    let holds = |parameter: f64| value(parameter).is_some_and(|own| (own > 0.0) == (first > 0.0));
    let ends = bisect(holds, from, to, BisectionStop::Halvings(60));
    // A change of sign through a pole is no change of orbits; whether a motion follows one has no
    // small values.
    let sizes = ends.into_iter().filter_map(value).map(f64::abs);
    let nearest = sizes.fold(f64::INFINITY, f64::min);
    let is_zero = nearest <= 1e-6 * first.abs().max(last.abs());
    (is_zero || change == OrbitChange::SecondImpact).then_some(ends)
}

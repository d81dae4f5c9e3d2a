//! The factors that limit the best design, found by varying each variable alone, by random designs
//! around it, and by the unit of the rest time.
//!
//! ```text
//! elasticity      (p/T) dT/dp, by steps of 1 % of p, of motions that are integrated
//! alone           how far a variable may go, the others held, before the objective is 1 % worse
//! flat            its whole range is within 1 %: it says nothing
//! lower, upper    alone it may go to that end, and nothing on its way is better than the end: the limit decides
//! limit           a constraint stops it
//! trade           something is lost on either side
//! share           the part of the box within 1 % of the best
//! ```
//!
//! With a density the mass follows the radius, or the radius the mass if that is varied.

use std::cell::Cell;
use std::f64::consts::PI;

use super::design::{EvaluatedDesign, Route};
use super::objective::Objective;
use super::question::OptimizationProblem;
use crate::genetic::{Space, generator};
use crate::impact::Parameter;
use crate::numeric::ode::root::{BisectionStop, bisect};

/// Relative difference of the objective up to which a design counts as equally good.
pub const WITHIN: f64 = 0.01;

/// The role of a variable in the best design.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VariableRole {
    /// Its whole range is equally good.
    Flat,
    /// The variable lies at its lower limit.
    Lower,
    /// The variable lies at its upper limit.
    Upper,
    /// A constraint stops it.
    Limit,
    /// The objective becomes worse on either side.
    Trade,
}

impl VariableRole {
    /// Every role.
    pub const ALL: [Self; 5] = [Self::Flat, Self::Lower, Self::Upper, Self::Limit, Self::Trade];

    /// The role in a word or two.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Lower => "lower end",
            Self::Upper => "upper end",
            Self::Limit => "constraint",
            Self::Trade => "trade",
        }
    }
}

/// The effect of one variable at the best design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensitivity {
    /// The parameter.
    pub parameter: Parameter,
    /// Its value there.
    pub value: f64,
    /// Its limits.
    pub limits: [f64; 2],
    /// (p/T) dT/dp of the objective T; `None` if it has no value on one side.
    pub elasticity: Option<f64>,
    /// Between these values, the others held, the objective is no more than 1 % worse.
    pub alone: [f64; 2],
    /// The least and the greatest value of the objective on its whole range, the others held,
    /// without constraints; `None` if the motion does not come to rest somewhere in it.
    pub range: Option<[f64; 2]>,
    /// The role that follows.
    pub role: VariableRole,
}

/// What the unit of the rest time does.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Unit"))]
pub struct Ends {
    /// The limits of the length, in m.
    pub lengths: [f64; 2],
    /// The rest times there, in seconds.
    pub seconds: [f64; 2],
    /// The same in units of time of each length.
    pub dimensionless: [f64; 2],
    /// The best lengths of those that were tried between the limits, the rest as it is best, in m:
    /// by the rest time in seconds, and by that in units of time.
    pub best_lengths: [f64; 2],
}

/// The factors that limit the best design.
#[derive(Debug, Clone, PartialEq)]
pub struct Decision {
    /// The variables, in their order.
    pub sensitivities: Vec<Sensitivity>,
    /// The objective of the best design, computed as for the others here: by closed forms if it has
    /// them.
    pub value: f64,
    /// The least objective of all designs that were tried here and keep the constraints.
    pub least: f64,
    /// Number of designs drawn from the whole box and from the ranges that are equally good.
    pub drawn: usize,
    /// The fraction of the box within 1 % of the best.
    pub share: f64,
    /// Least and greatest value of every variable among the designs within 1 %.
    pub extents: Vec<[f64; 2]>,
    /// Some of those designs.
    pub points: Vec<Vec<f64>>,
    /// The constraints that have no more than 1 % to spare.
    pub active: Vec<String>,
    /// The effect of the unit of the rest time, if a rest time is the objective and the length is
    /// searched.
    pub ends: Option<Ends>,
    /// The objective with every material and the other values of the best design; `None` for one
    /// that does not come to rest.
    pub materials: Vec<Option<f64>>,
}

/// Relative difference below which values are the same.
const SAME: f64 = 1e-6;

/// Numbers of designs drawn from the whole box, and from the box of the ranges that are equally
/// good.
const DRAWN: [usize; 2] = [4000, 2000];

/// First stream of random numbers, far from those of the runs.
const STREAM: u64 = 1 << 40;

/// Steps from the best value of a variable to its limit.
const STEPS: i32 = 40;

impl Decision {
    /// The sensitivities of this design, the best of its box, by integration.
    pub(super) fn new(
        question: &OptimizationProblem,
        space: &Space,
        design: &EvaluatedDesign,
    ) -> Self {
        let best: &[f64] = &design.point;
        let probe = Probe {
            question,
            space,
            fewer: match question.follow(best, Route::Chain, false) {
                _ if question.main_mass.is_some() => 100,
                Ok(design) if design.integrated => 10,
                _ => 1,
            },
            least: Cell::new(f64::INFINITY),
        };
        let value = probe.value(best).unwrap_or(f64::INFINITY);
        probe.least.set(value);
        let level = value * (1.0 + WITHIN);
        let sensitivities: Vec<Sensitivity> = (0..question.variables.len())
            .map(|index| probe.sensitivity(best, index, level))
            .collect();
        let mut near: Vec<[f64; 2]> =
            sensitivities.iter().map(|sensitivity| sensitivity.alone).collect();
        near.extend(space.bounds().iter().skip(near.len()));
        // A variable fixed at one value has no range of its own.
        for (range, [lower, upper]) in near.iter_mut().zip(space.bounds()) {
            let least = 1e-3 * (upper - lower);
            *range = [
                range[0].min(range[1] - least).max(*lower),
                range[1].max(range[0] + least).min(*upper),
            ];
        }
        let (share, points) = probe.share(&near, level);
        let extents = (0..best.len()).map(|index| {
            let values = points.iter().map(|point| point[index]).chain([best[index]]);
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| {
                [least.min(value), most.max(value)]
            })
        });
        Self {
            extents: extents.collect(),
            share,
            drawn: probe.drawn().into_iter().sum(),
            points,
            active: probe.active(design),
            ends: probe.ends(best),
            value,
            materials: (0..question.materials.len())
                .map(|number| {
                    let mut point = best.to_vec();
                    if let Some(gene) = point.get_mut(question.variables.len()) {
                        *gene = number as f64 + 0.5;
                    }
                    probe.value(&point)
                })
                .collect(),
            sensitivities,
            least: probe.least.get(),
        }
    }
}

/// Designs of one question, followed by closed forms.
struct Probe<'a> {
    question: &'a OptimizationProblem,
    space: &'a Space,
    /// The divisor of the number of designs: about ten for designs without closed forms, a hundred
    /// with a main mass, which has none.
    fewer: usize,
    /// The least objective so far of a design that keeps the constraints.
    least: Cell<f64>,
}

impl Probe<'_> {
    /// The objective at a point, without constraints; `None` if it has no value.
    fn value(&self, point: &[f64]) -> Option<f64> {
        let objective = *self.question.objectives.first()?;
        objective.value(&self.question.follow(point, Route::Chain, objective.is_of_contact()).ok()?)
    }

    /// The objective of a point; `None` if it breaks a constraint.
    fn feasible(&self, point: &[f64]) -> Option<f64> {
        self.judged(point)[1]
    }

    /// The objective of a point without constraints, and with them.
    fn judged(&self, point: &[f64]) -> [Option<f64>; 2] {
        let evaluation = self.question.bounded_evaluation(point, self.least.get(), &mut 0);
        let value = Some(evaluation.value()).filter(|value| value.is_finite());
        let kept =
            value.filter(|_| evaluation.is_feasible(self.question.genetic.constraint_tolerance));
        self.least.set(kept.map_or(self.least.get(), |kept| self.least.get().min(kept)));
        [value, kept]
    }

    /// The point moved to the surface of the density, if there is one; `None` if that leaves the
    /// box.
    fn on_surface(&self, mut point: Vec<f64>, moved: Option<usize>) -> Option<Vec<f64>> {
        let Some(density) = self.question.density else {
            return Some(point);
        };
        let variables = &self.question.variables;
        let place =
            |parameter| variables.iter().position(|variable| variable.parameter == parameter);
        let (mass, radius) = (place(Parameter::Mass), place(Parameter::Radius));
        if moved.is_some() && moved != mass && moved != radius {
            return Some(point);
        }
        let of_radius = |radius: f64| density * 4.0 / 3.0 * PI * radius.powi(3);
        match (mass, radius) {
            (Some(mass), Some(radius)) if moved == Some(mass) => {
                point[radius] = (point[mass] / of_radius(1.0)).cbrt();
            }
            (Some(mass), Some(radius)) => point[mass] = of_radius(point[radius]),
            _ => {}
        }
        self.space.contains(&point).then_some(point)
    }

    fn with_variable(&self, best: &[f64], index: usize, value: f64) -> Option<Vec<f64>> {
        let mut point = best.to_vec();
        point[index] = value;
        self.on_surface(point, Some(index))
    }

    /// Values from the best one to a limit, closer together near the smaller where the range has
    /// decades.
    fn values_towards(&self, from: f64, to: f64) -> impl Iterator<Item = f64> + use<> {
        let decades = (to / from).abs().max((from / to).abs()) > 10.0;
        let steps = if self.fewer > 1 { STEPS / 4 } else { STEPS };
        (1..=steps).map(move |step| {
            let part = f64::from(step) / f64::from(steps);
            match decades {
                _ if step == steps => to,
                true => from * (to / from).powf(part),
                false => from + part * (to - from),
            }
        })
    }

    fn sensitivity(&self, best: &[f64], index: usize, level: f64) -> Sensitivity {
        let variable = self.question.variables[index];
        let (parameter, value) = (variable.parameter, best[index]);
        let limits = [variable.lower, variable.upper];
        let good = |value: f64| {
            let point = self.with_variable(best, index, value)?;
            self.feasible(&point).filter(|objective| *objective <= level)
        };
        let reach = |limit: f64| {
            let mut last = value;
            for next in self.values_towards(value, limit) {
                if good(next).is_none() {
                    let halvings = if self.fewer > 1 { 12 } else { 30 };
                    let [inside, _] = bisect(
                        |value| good(value).is_some(),
                        last,
                        next,
                        BisectionStop::Halvings(halvings),
                    );
                    return inside;
                }
                last = next;
            }
            limit
        };
        let alone = limits.map(reach);
        // With a density some values are not possible.
        let tried = limits.into_iter().flat_map(|limit| self.values_towards(value, limit));
        let tried = tried.filter_map(|value| self.with_variable(best, index, value));
        let tried: Vec<[Option<f64>; 2]> = tried.map(|point| self.judged(&point)).collect();
        let whole: Option<Vec<f64>> =
            tried.iter().map(|[value, _]| *value).chain([self.value(best)]).collect();
        let range = whole.map(|values| {
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            [least, values.into_iter().fold(f64::NEG_INFINITY, f64::max)]
        });
        let kept = tried.iter().filter_map(|[_, kept]| *kept);
        let least = kept.chain(self.value(best)).fold(f64::INFINITY, f64::min);
        // Whether the limit is the best of all values tried on the way.
        let is_end = |end: usize| {
            let point = self.with_variable(best, index, limits[end]);
            let at_end = point.and_then(|point| self.feasible(&point));
            alone[end] == limits[end] && at_end.is_some_and(|at_end| at_end <= least * (1.0 + SAME))
        };
        // Whether the values just beyond the equally good range are forbidden, not only worse.
        let is_forbidden = |end: usize| {
            let beyond = alone[end] + 1e-3 * (limits[end] - alone[end]);
            alone[end] != limits[end]
                && self.with_variable(best, index, beyond).is_none_or(|point| {
                    self.value(&point).is_some_and(|objective| objective <= level)
                })
        };
        let role = match range {
            Some([least, greatest]) if greatest <= least * (1.0 + WITHIN) => VariableRole::Flat,
            _ if is_end(0) => VariableRole::Lower,
            _ if is_end(1) => VariableRole::Upper,
            _ if is_forbidden(0) || is_forbidden(1) => VariableRole::Limit,
            _ => VariableRole::Trade,
        };
        Sensitivity {
            parameter,
            value,
            limits,
            elasticity: self.elasticity(best, index),
            alone,
            range,
            role,
        }
    }

    /// The elasticity by integrated motions, one-sided at a limit.
    fn elasticity(&self, best: &[f64], index: usize) -> Option<f64> {
        const STEP: f64 = 0.01;
        let variable = self.question.variables[index];
        let objective = *self.question.objectives.first()?;
        let value = best[index];
        let ends = [
            (value * (1.0 - STEP)).max(variable.lower),
            (value * (1.0 + STEP)).min(variable.upper),
        ];
        let at = |end: f64| {
            let point = self.with_variable(best, index, end).unwrap_or_else(|| {
                let mut point = best.to_vec();
                point[index] = end;
                point
            });
            let design =
                self.question.follow(&point, Route::Integration, objective.is_of_contact()).ok()?;
            objective.value(&design)
        };
        let [below, above] = [at(ends[0])?, at(ends[1])?];
        Some((above / below).ln() / (ends[1] / ends[0]).ln()).filter(|slope| slope.is_finite())
    }

    /// Numbers of designs drawn from the whole box, and from the ranges that are equally good.
    fn drawn(&self) -> [usize; 2] {
        DRAWN.map(|count| count / self.fewer)
    }

    /// The fraction of the box within the level, and designs there.
    fn share(&self, near: &[[f64; 2]], level: f64) -> (f64, Vec<Vec<f64>>) {
        let mut points = Vec::new();
        let mut shares = [0.0; 2];
        let whole = self.space.bounds();
        let drawn = self.drawn();
        for (turn, bounds) in [whole, near].into_iter().enumerate() {
            let Ok(space) = Space::new(bounds.to_vec()) else {
                continue;
            };
            let mut generator = generator(self.question.seed, STREAM + turn as u64);
            let before = points.len();
            for _ in 0..drawn[turn] {
                let Some(point) = self.on_surface(space.draw(&mut generator), None) else {
                    continue;
                };
                if self.feasible(&point).is_some_and(|objective| objective <= level) {
                    points.push(point);
                }
            }
            shares[turn] = (points.len() - before) as f64 / drawn[turn] as f64;
        }
        let part =
            |(near, whole): (&[f64; 2], &[f64; 2])| (near[1] - near[0]) / (whole[1] - whole[0]);
        let volume: f64 = near.iter().zip(whole).map(part).product();
        // A few designs from the whole box are not a reliable estimate.
        match shares[0] * drawn[0] as f64 >= 20.0 {
            true => (shares[0], points),
            false => (shares[1] * volume, points),
        }
    }

    fn active(&self, best: &EvaluatedDesign) -> Vec<String> {
        let evaluation = self.question.evaluation(best);
        let words = self.question.constraints();
        let mut active: Vec<String> = Vec::new();
        let limits = self.question.limits.len();
        for (index, excess) in evaluation.inequalities.iter().enumerate() {
            let word = if index < limits { words.get(index) } else { words.last() };
            if *excess > -WITHIN {
                active.extend(word.cloned());
            }
        }
        if self.question.density.is_some() {
            active.extend(words.get(limits).cloned());
        }
        active
    }

    fn ends(&self, best: &[f64]) -> Option<Ends> {
        let objective = self.question.objectives.first()?;
        let variables = &self.question.variables;
        let index =
            variables.iter().position(|variable| variable.parameter == Parameter::Length)?;
        if !objective.is_rest_time() {
            return None;
        }
        let lengths = [variables[index].lower, variables[index].upper];
        let both = |length: f64| {
            let mut point = best.to_vec();
            point[index] = length;
            let design =
                self.question.follow(&point, Route::Chain, self.question.needs_contact()).ok()?;
            let units = [Objective::RestTime, Objective::DimensionlessRestTime];
            let [seconds, dimensionless] = units.map(|objective| objective.value(&design));
            let tolerance = self.question.genetic.constraint_tolerance;
            let keeps = self.question.evaluation(&design).violation(tolerance) == 0.0;
            Some(([seconds?, dimensionless?], keeps))
        };
        let [(short, _), (long, _)] = [both(lengths[0])?, both(lengths[1])?];
        let mut least = [f64::INFINITY; 2];
        let mut best_lengths = [best[index]; 2];
        let tried = lengths.into_iter().flat_map(|limit| self.values_towards(best[index], limit));
        for length in lengths.into_iter().chain([best[index]]).chain(tried) {
            let Some((times, true)) = both(length) else {
                continue;
            };
            for unit in 0..2 {
                if times[unit] < least[unit] * (1.0 - SAME) {
                    (least[unit], best_lengths[unit]) = (times[unit], length);
                }
            }
        }
        Some(Ends {
            lengths,
            seconds: [short[0], long[0]],
            dimensionless: [short[1], long[1]],
            best_lengths,
        })
    }
}

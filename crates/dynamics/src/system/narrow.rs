//! Arguments of functions that change faster than the motion: a narrow well in space, a steep
//! function of the velocity, a pulse that moves with the motion.
//!
//! ```text
//! exp(u), tanh(u), 1/u, ...     u(t*) = 0 or u'(t*) = 0:   width  w = D/|u'|, sqrt(2 D/|u''|),   D: the change of u that matters
//! a step ends at  t* - 2 w, 4 w, 8 w, ...
//! ```
//!
//! An integrator evaluates the right sides only along its step, where a distant well does not show.
//! Its argument u, however, is as smooth as the states, so that the narrow places of the function
//! are known in advance from the zeros and extrema of u. `conservative::features` does the same for
//! a force at rest.

use std::collections::BTreeMap;

use crate::exact::rational::to_f64;
use crate::expr::{Expr, Function, Node};
use crate::series::guard::Guard;
use crate::symbol::Symbol;
use num_traits::Signed as _;

use super::polynomial::{roots, value};

/// The argument of a function that may change fast, with the behaviour of the function.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Argument {
    pub(super) expression: Expr,
    pub(super) kind: FunctionGrowth,
}

/// The behaviour of a function for large and small arguments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FunctionGrowth {
    /// Growth without bound for large arguments, and decay to zero for small ones: `exp`.
    Growing,
    /// Growth on both sides: `sinh`, `cosh`.
    GrowingBothWays,
    /// Saturation far from zero: `tanh`.
    Bounded,
    /// Slow saturation: `atan`.
    Slow,
    /// A change on the scale of the argument over this exponent: powers, logarithms.
    Power(f64),
}

/// Ratio of a step to the width of a narrow place from which on the step might miss it.
const TIMES: f64 = 16.0;

/// Relative error of an argument, in units of its largest value.
const ROUNDING: f64 = 1e-13;

/// Number of widths beyond which a narrow place has no effect in double precision, so that steps
/// may end farther apart.
const FAR: f64 = 32.0;

/// Returns the arguments in the right sides that depend on the states. Periodic functions are left
/// out because they show everywhere, corners and roots that begin at one of these guards because
/// they end a step anyway, and functions of the time alone because their critical times are given.
pub(super) fn arguments(
    right: &[Expr],
    states: &[Symbol],
    guards: &[Guard],
    values: &BTreeMap<Symbol, f64>,
) -> Vec<Argument> {
    let mut found: Vec<Argument> = Vec::new();
    for node in right.iter().flat_map(Expr::unique_nodes) {
        let Some(argument) = argument(node) else {
            continue;
        };
        let moves = states.iter().any(|state| argument.expression.contains(*state));
        let begins_at_guard = || {
            let root = matches!(argument.kind, FunctionGrowth::Power(_))
                .then(|| root_of_square(&argument.expression, values));
            let root = root.flatten().map(|root| Guard::new(root, values));
            root.is_some_and(|root| guards.iter().any(|guard| root.ratio_to(guard).is_some()))
        };
        if moves && !begins_at_guard() && !found.contains(&argument) {
            found.push(argument);
        }
    }
    found
}

/// Returns `u` for an expression that is a number times `u^2`; `None` for any other.
pub(super) fn root_of_square<'a>(
    expression: &'a Expr,
    values: &BTreeMap<Symbol, f64>,
) -> Option<&'a Expr> {
    let is_number = |factor: &Expr| factor.symbols().iter().all(|name| values.contains_key(name));
    let (_, factors) = expression.factors();
    let mut others = factors.iter().filter(|factor| !is_number(factor));
    let (only, None) = (others.next()?, others.next()) else {
        return None;
    };
    match only.node() {
        Node::Power(base, exponent) if *exponent == Expr::from(2) => Some(base),
        _ => None,
    }
}

/// Returns the guards of the corners in some expressions.
pub(super) fn guards_in(expressions: &[Expr], values: &BTreeMap<Symbol, f64>) -> Vec<Guard> {
    let nodes = expressions.iter().flat_map(Expr::unique_nodes);
    let argument = |node: &Expr| match node.node() {
        Node::Function(Function::Absolute | Function::Sign | Function::Step, arguments) => {
            arguments.first().cloned()
        }
        Node::Function(Function::Maximum | Function::Minimum, arguments) => {
            match arguments.as_slice() {
                [one, other] => Some(one - other),
                _ => None,
            }
        }
        _ => None,
    };
    nodes.filter_map(argument).map(|argument| Guard::new(&argument, values)).collect()
}

fn argument(node: &Expr) -> Option<Argument> {
    /// Exponent from which on a power is like a bump or a wall.
    const HIGH: f64 = 8.0;
    let (expression, kind) = match node.node() {
        Node::Power(base, exponent) => match exponent.as_number() {
            Some(number) => {
                let ordinary = number.is_integer() && number.is_positive() && to_f64(number) < HIGH;
                (!ordinary).then(|| (base.clone(), FunctionGrowth::Power(to_f64(&number.abs()))))?
            }
            None => {
                let logarithm = Expr::function(Function::Log, vec![base.clone()]).ok()?;
                (&logarithm * exponent, FunctionGrowth::Growing)
            }
        },
        Node::Function(function, arguments) => {
            let kind = match function {
                Function::Exp => FunctionGrowth::Growing,
                Function::Sinh | Function::Cosh => FunctionGrowth::GrowingBothWays,
                Function::Tanh => FunctionGrowth::Bounded,
                Function::Atan => FunctionGrowth::Slow,
                Function::Log => FunctionGrowth::Power(1.0),
                _ => return None,
            };
            (arguments.first()?.clone(), kind)
        }
        _ => return None,
    };
    Some(Argument { expression, kind })
}

impl FunctionGrowth {
    /// Returns the change of the argument over which the function changes, at this argument with
    /// this error; `None` if the function is practically constant.
    fn change(self, argument: f64, error: f64) -> Option<f64> {
        /// Argument beyond which an exponential is negligible, whatever its factor.
        const NOTHING: f64 = 150.0;
        match self {
            Self::Growing if argument + error < -NOTHING => None,
            Self::Bounded if argument.abs() - error > NOTHING => None,
            Self::Growing | Self::GrowingBothWays | Self::Bounded => Some(1.0),
            Self::Slow => Some(argument.abs().max(1.0)),
            Self::Power(exponent) => Some(argument.abs() / exponent),
        }
    }

    /// Whether a zero of the argument is a narrow place; for a power it is a pole, a root or a flat
    /// point instead.
    fn turns_at_zero(self) -> bool {
        !matches!(self, Self::Power(_))
    }
}

/// Returns the length of a step that ends beside the next narrow place of a function; `None` if the
/// step need not be shortened. `series` is the argument along the step, in powers of the time since
/// its start.
pub(super) fn end_of_step(kind: FunctionGrowth, series: &[f64], length: f64) -> Option<f64> {
    if is_wide(kind, series, length) || !series.iter().all(|value| value.is_finite()) {
        return None;
    }
    let slope = derivative(series);
    let curvature = derivative(&slope);
    let mut places = roots(&slope, 0.0, length);
    if kind.turns_at_zero() {
        places.extend(roots(series, 0.0, length));
    }
    let largest =
        series.iter().rev().fold(0.0, |sum, coefficient| sum * length + coefficient.abs());
    let ends = places.into_iter().filter_map(|(place, _)| {
        let at = [series, &slope, &curvature].map(|series| value(series, place));
        end_before(place, width(kind, at, ROUNDING * largest)?, length)
    });
    ends.fold(None, |first: Option<f64>, end| Some(first.map_or(end, |first| first.min(end))))
}

/// The fractions of a step at which an argument is evaluated first.
pub(super) const COARSE: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Returns the fraction of a step at which it should end, from the values of the argument at
/// [`COARSE`] and, if these differ much, at further places; `None` if it need not be shortened.
pub(super) fn end_by_values(
    kind: FunctionGrowth,
    coarse: [f64; 5],
    value: impl Fn(f64) -> f64,
) -> Option<f64> {
    const CELLS: usize = 32;
    /// Relative accuracy of the search for an extremum.
    const CLOSELY: f64 = 1e-9;
    /// Number of extrema of an argument beyond which the cells are too wide to show them.
    const MOST_TURNS: usize = 8;
    let most = coarse.iter().fold(f64::NEG_INFINITY, |most, value| most.max(*value));
    let least = coarse.iter().fold(f64::INFINITY, |least, value| least.min(*value));
    let wide = match kind {
        FunctionGrowth::Power(exponent) => {
            let bent =
                coarse.windows(3).map(|around| (around[0] - 2.0 * around[1] + around[2]).abs());
            // The argument is wide if the width sqrt(2 |u|/(e |u''|)), with u'' from differences,
            // exceeds a quarter of the step, four times what is needed.
            least * most > 0.0
                && 2.0 * least.abs().min(most.abs()) > exponent * bent.fold(0.0, f64::max)
        }
        _ => most - least < 0.25 * TIMES,
    };
    let cell = 1.0 / CELLS as f64;
    let values: Vec<f64> = match wide {
        true => return None,
        false => (0..=CELLS).map(|index| value(cell * index as f64)).collect(),
    };
    if !values.iter().all(|value| value.is_finite()) {
        return None;
    }
    let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let mut first: Option<f64> = None;
    let mut turns = 0;
    for index in 1..CELLS {
        let [before, here, after] = [values[index - 1], values[index], values[index + 1]];
        let (slope, curvature) = (0.5 * (after - before), before - 2.0 * here + after);
        // Each point is responsible for half a cell on either side; the first and the last also for
        // the ends.
        let from = if index == 1 { -1.0 } else { -0.5 };
        let to = if index + 1 == CELLS { 1.0 } else { 0.5 };
        let turn = Some(-slope / curvature).filter(|part| (from..to).contains(part));
        turns += usize::from(turn.is_some());
        let zeros =
            [(before, here, -1.0), (here, after, 0.0)].into_iter().skip(usize::from(index > 1));
        let zeros = zeros
            .filter(|(one, other, _)| kind.turns_at_zero() && one * other <= 0.0 && one != other);
        let zeros = zeros.map(|(one, other, cell)| cell + one / (one - other));
        for part in turn.into_iter().chain(zeros) {
            let rate = (slope + part * curvature) / cell;
            let (place, at) = match turn == Some(part) {
                true => turned(cell * (index as f64 + part), cell, &value),
                false => (cell * (index as f64 + part), 0.0),
            };
            let width = width(kind, [at, rate, curvature / (cell * cell)], CLOSELY * largest);
            let end = width.and_then(|width| end_before(place, width, 1.0));
            first = end.map_or(first, |end| Some(first.map_or(end, |first| first.min(end))));
        }
    }
    match turns > MOST_TURNS {
        true => Some(0.25),
        false => first,
    }
}

/// Returns the extremum of an argument near a place, and its value there, by parabolas through
/// closer and closer points.
fn turned(place: f64, cell: f64, value: &impl Fn(f64) -> f64) -> (f64, f64) {
    const TIMES: usize = 4;
    let (mut place, mut apart) = (place.clamp(0.0, 1.0), cell / 8.0);
    for _ in 0..TIMES {
        let middle = place.clamp(apart, 1.0 - apart);
        let [before, here, after] = [middle - apart, middle, middle + apart].map(value);
        let part = 0.5 * (before - after) / (before - 2.0 * here + after);
        if !part.is_finite() {
            break;
        }
        place = (middle + apart * part.clamp(-1.0, 1.0)).clamp(0.0, 1.0);
        apart /= 8.0;
    }
    (place, value(place))
}

/// Returns the width of a narrow place in time, from the argument with its error and its first and
/// second derivative there; `None` if the function is practically constant.
fn width(kind: FunctionGrowth, [argument, slope, curvature]: [f64; 3], error: f64) -> Option<f64> {
    let change = kind.change(argument, error)?;
    let width = f64::min(change / slope.abs(), (2.0 * change / curvature.abs()).sqrt());
    (width > 0.0).then_some(width)
}

/// Returns the length of a step that ends before a narrow place at this distance; `None` if the
/// place is wide, or so near that the step resolves it.
fn end_before(distance: f64, width: f64, length: f64) -> Option<f64> {
    let width = width.max(1e-13 * length);
    let near = 2.0 * width;
    if TIMES * width >= length || distance <= 1.01 * near {
        return None;
    }
    let mut rung = near;
    loop {
        let next = if rung < FAR * width { 2.0 * rung } else { 4.0 * rung };
        if 1.01 * next >= distance {
            return Some(distance - rung);
        }
        rung = next;
    }
}

/// Whether the argument changes so little along a step that the function cannot have a narrow place
/// on it.
fn is_wide(kind: FunctionGrowth, series: &[f64], length: f64) -> bool {
    let (mut first, mut second) = (0.0, 0.0);
    let mut power = 1.0;
    for (order, coefficient) in series.iter().enumerate().skip(1) {
        power *= length;
        let term = order as f64 * coefficient.abs() * power;
        first += term;
        second += order as f64 * term;
    }
    match kind {
        FunctionGrowth::Power(exponent) => {
            let size = series[0].abs();
            let monotonic = 2.0 * series.get(1).map_or(0.0, |slope| slope.abs() * length) > first;
            monotonic || first < 0.5 * size && exponent * second < TIMES * TIMES * size
        }
        _ => first < TIMES && second < TIMES * TIMES,
    }
}

fn derivative(series: &[f64]) -> Vec<f64> {
    let terms = series.iter().enumerate().skip(1);
    terms.map(|(order, coefficient)| order as f64 * coefficient).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> Vec<String> {
        let expression: Expr = text.parse().expect(text);
        let values = BTreeMap::from([(Symbol::new("k"), 3.0)]);
        let expressions = [expression];
        let guards = guards_in(&expressions, &values);
        let found = arguments(&expressions, &["x".into(), "v".into()], &guards, &values);
        found.iter().map(|argument| argument.expression.to_string()).collect()
    }

    #[test]
    fn arguments_that_move_with_the_states_are_found() {
        for (text, expected) in [
            ("x + x^3 - sin(1e6*x) + abs(v)", vec![]),
            ("exp(-1e6*t^2) + x", vec![]),
            ("x*exp(-1e6*(x - t)^2)", vec!["-1000000*(x - t)^2"]),
            ("tanh(1e3*v)/(1 + x^2)", vec!["1000*v", "x^2 + 1"]),
            ("(k*(x - 2)^2)^(3/4)*H(4 - 2*x)", vec![]),
            ("((x - 2)^2)^(3/4)*H(x - 1)", vec!["(x - 2)^2"]),
        ] {
            let mut found = found(text);
            let mut expected: Vec<String> =
                expected.iter().map(|text| text.parse::<Expr>().expect(text).to_string()).collect();
            found.sort();
            expected.sort();
            assert_eq!(found, expected, "{text}");
        }
    }

    #[test]
    fn a_step_ends_beside_the_first_narrow_place() {
        // exp(-((s - 1/2)/w)^2), w = 1e-3: at 2 w, 4 w, ... before the middle.
        let series = [-0.25e6, 1e6, -1e6];
        let end = end_of_step(FunctionGrowth::Growing, &series, 1.0).expect("an end");
        assert!((0.3..0.499).contains(&end), "{end}");
        let mut at = 0.0;
        for _ in 0..12 {
            let middle = 0.5 - at;
            let series = [-middle * middle * 1e6, 2e6 * middle, -1e6];
            let Some(step) = end_of_step(FunctionGrowth::Growing, &series, 1.0 - at) else {
                break;
            };
            at += step;
        }
        assert!((0.5 - at - 2e-3).abs() < 1e-4, "{at}");
        // Far below zero an exponential is nothing, and what is wide is seen by itself.
        assert_eq!(end_of_step(FunctionGrowth::Growing, &[-1.25e6, 1e6, -1e6], 1.0), None);
        assert_eq!(end_of_step(FunctionGrowth::Growing, &[-0.25, 1.0, -1.0], 1.0), None);
        // A steep tanh, and a pole beside the real line.
        assert!(end_of_step(FunctionGrowth::Bounded, &[-3e4, 1e5], 1.0).is_some());
        assert!(end_of_step(FunctionGrowth::Power(1.0), &[0.25 + 1e-8, -1.0, 1.0], 1.0).is_some());
        assert_eq!(end_of_step(FunctionGrowth::Power(1.0), &[1.25, -1.0, 1.0], 1.0), None);
    }
}

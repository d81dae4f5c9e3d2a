//! Narrow features of a force: corners, steep walls and narrow bumps, found from the structure of
//! its expression.
//!
//! A grid of points, however fine, misses a bump narrower than itself:
//! `x - 1e5*(x + 1)*exp(-1e4*(x + 1)^2)` looks like `x`. The expression knows better. With `u` the
//! argument of a function or the base of a power, the force may vary on a short scale only where
//! `u` takes a special value or is stationary:
//!
//! ```text
//! H(u), abs(u), sgn(u), max(u, v), min(u, v)    u = 0, u - v = 0                 a corner
//! u^e, log(u)                                   u = 0, u' = 0                    width |u/(e u')|, sqrt(|2 u/(e u'')|)
//! asin(u), acos(u)                              u = -1, u = 1, u' = 0            a corner
//! exp(u), tanh(u), sin(u), ...                  u = 0, u' = 0                    width 1/|u'|, sqrt(2/|u''|)
//! ```
//!
//! The zeros are found from the inside out: the places of the arguments of `u` are points of the
//! grid on which the zeros of `u` are sought, and polynomials are taken apart by their derivatives,
//! so that none of their zeros can slip through.

use std::collections::BTreeMap;

use num_traits::{Signed, ToPrimitive};

use crate::exact::polynomial::Monomial;
use crate::exact::rational::to_f64;
use crate::expr::{CompiledFunction, Expr, Function, Node};
use crate::numeric::ode::polynomial::real_zeros;
use crate::numeric::ode::root::find_root;
use crate::symbol::Symbol;

/// A position about which a force may vary on a short scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature {
    /// The position.
    pub place: f64,
    /// The distance over which the force may change; zero at a corner, a jump or a pole.
    pub width: f64,
    /// Whether it is a pole, a root or a logarithm: the force varies the faster the closer to it.
    pub singular: bool,
}

/// The arguments inside a force at whose zeros and stationary points it may vary on a short scale.
#[derive(Clone, Debug, Default)]
pub struct Features {
    parts: Vec<InnerFunction>,
}

/// The behaviour of a function that decides where it varies on a short scale.
#[derive(Clone, Copy, Debug, PartialEq)]
enum FunctionKind {
    /// A corner if the argument is zero.
    Corner,
    /// A corner if the argument is plus or minus one.
    Inverse,
    /// A change on the scale of one in the argument; the flag says whether it repeats.
    Scale { waves: bool },
    /// A change on the scale of the argument over this exponent.
    Power(f64),
}

#[derive(Clone, Debug)]
struct InnerFunction {
    kind: FunctionKind,
    argument: CompiledFunction,
    slope: CompiledFunction,
    curvature: CompiledFunction,
    /// The coefficients of an argument that is a polynomial, lowest first.
    polynomial: Option<Vec<f64>>,
}

/// Points of the grid on which the zeros of arguments are sought, beside the places known already.
const GRID: usize = 128;

/// The most points any grid may have.
const MOST_POINTS: usize = 4096;

/// An exponent at or above this makes a power a narrow bump or a steep wall.
const HIGH_POWER: f64 = 8.0;

/// Ratio of the widths of neighbouring panels beside a narrow place.
const GROWTH: f64 = 4.0;

impl Features {
    /// The structure of `force` as a function of `coordinate`, with numbers for every other symbol;
    /// symbols without a number, such as the velocity, are zero.
    pub fn new(force: &Expr, coordinate: Symbol, numbers: &BTreeMap<Symbol, f64>) -> Self {
        let mut names = force.symbols();
        names.insert(coordinate);
        let at_numbers: BTreeMap<Symbol, Expr> = names
            .iter()
            .filter(|&&name| name != coordinate)
            .filter_map(|name| {
                let value = numbers.get(name).copied().unwrap_or(0.0);
                Some((*name, Expr::number(crate::exact::from_f64(value)?)))
            })
            .collect();
        let Ok(force) = force.substitute_all(&at_numbers) else {
            return Self::default();
        };
        let mut parts = Vec::new();
        let Ok(()) = force.fold(|expr, _: &[()]| {
            parts.extend(part(expr, coordinate));
            Ok::<(), std::convert::Infallible>(())
        });
        Self { parts }
    }

    /// Whether the force has no feature at any position.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Whether some part of the force oscillates, as a sine does.
    pub fn waves(&self) -> bool {
        self.parts.iter().any(|part| part.kind == FunctionKind::Scale { waves: true })
    }

    /// The places between `from` and `to`, and a little beyond, in order.
    pub fn between(&self, from: f64, to: f64) -> Vec<Feature> {
        let (from, to) = (from.min(to), from.max(to));
        let length = to - from;
        if !(length > 0.0 && length.is_finite()) {
            return vec![];
        }
        // A bump just outside reaches in.
        let (low, high) = (from - length / 8.0, to + length / 8.0);
        let mut found: Vec<Feature> = Vec::new();
        let mut points = GRID;
        for part in &self.parts {
            let mut grid: Vec<f64> =
                (0..=points).map(|k| low + (high - low) * k as f64 / points as f64).collect();
            grid.extend(graded(&found, low, high));
            grid.sort_by(f64::total_cmp);
            let features = part.features(&grid);
            if part.kind == (FunctionKind::Scale { waves: true }) {
                let waves = variation(&part.argument, &grid);
                points = points.max((2.0 * waves) as usize).min(MOST_POINTS);
            }
            found.extend(features);
        }
        found.sort_by(|one, other| one.place.total_cmp(&other.place));
        found.dedup_by(|second, first| {
            let same = (second.place - first.place).abs() <= 1e-14 * length;
            if same {
                first.width = first.width.min(second.width);
                first.singular |= second.singular;
            }
            same
        });
        found
    }

    /// Points that divide the interval from `from` to `to` so that on each piece the force is
    /// smooth and varies on no shorter scale than the length of the piece: corners, and steps of
    /// growing length on both sides of a narrow place. The ends are left out; the order is
    /// ascending.
    pub fn cuts(&self, from: f64, to: f64) -> Vec<f64> {
        let (low, high) = (from.min(to), from.max(to));
        let mut cuts = graded(&self.between(low, high), low, high);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|second, first| (*second - *first).abs() <= 1e-14 * (high - low));
        cuts
    }
}

/// The places themselves and, where they are narrow, points at growing distances from them.
fn graded(features: &[Feature], low: f64, high: f64) -> Vec<f64> {
    let length = high - low;
    let mut points = Vec::new();
    for feature in features {
        // Beside a singularity the force varies on the scale of the distance from it.
        let outside = f64::max(low - feature.place, feature.place - high).max(0.0);
        let width = if feature.singular { 0.5 * outside } else { feature.width };
        // A feature as wide as the interval needs no cut.
        if width > length / 16.0 {
            continue;
        }
        points.push(feature.place);
        if width > 0.0 && points.len() < MOST_POINTS {
            let mut distance = 2.0 * width.max(1e-13 * length);
            while distance < length {
                points.extend([feature.place - distance, feature.place + distance]);
                distance *= GROWTH;
            }
        }
    }
    points.retain(|&point| low < point && point < high);
    points
}

/// The inner function of a node: its argument, if that contains the coordinate and the node can
/// have a corner, a pole or a steep slope.
fn part(expr: &Expr, coordinate: Symbol) -> Option<InnerFunction> {
    let (kind, argument) = match expr.node() {
        Node::Power(base, exponent) if exponent.contains(coordinate) => {
            let logarithm = Expr::function(Function::Log, vec![base.clone()]).ok()?;
            (FunctionKind::Scale { waves: false }, &logarithm * exponent)
        }
        Node::Power(base, exponent) => {
            let exponent = exponent.as_number()?;
            let size = to_f64(&exponent.abs());
            let ordinary = exponent.is_integer() && exponent.is_positive() && size < HIGH_POWER;
            if ordinary {
                return None;
            }
            (FunctionKind::Power(size), base.clone())
        }
        Node::Function(function, arguments) => {
            use Function::{
                Absolute, Acos, Asin, Cos, Log, Maximum, Minimum, Sign, Sin, Step, Tan,
            };
            let kind = match function {
                Absolute | Sign | Step | Maximum | Minimum => FunctionKind::Corner,
                Asin | Acos => FunctionKind::Inverse,
                Log => FunctionKind::Power(1.0),
                Sin | Cos | Tan => FunctionKind::Scale { waves: true },
                _ => FunctionKind::Scale { waves: false },
            };
            let argument = match arguments.as_slice() {
                [one] => one.clone(),
                [one, other] => one - other,
                _ => return None,
            };
            (kind, argument)
        }
        _ => return None,
    };
    if !argument.contains(coordinate) {
        return None;
    }
    let slope = argument.differentiate(coordinate).ok()?;
    let curvature = slope.differentiate(coordinate).ok()?;
    let compiled = |expr: &Expr| CompiledFunction::new(expr, &[coordinate]).ok();
    Some(InnerFunction {
        kind,
        polynomial: polynomial(&argument, coordinate),
        argument: compiled(&argument)?,
        slope: compiled(&slope)?,
        curvature: compiled(&curvature)?,
    })
}

/// The coefficients of an expression that is a polynomial in the coordinate alone.
fn polynomial(expr: &Expr, coordinate: Symbol) -> Option<Vec<f64>> {
    const HIGHEST: usize = 64;
    let polynomial = expr.to_polynomial(&mut |_| None).ok()??;
    let mut coefficients = vec![0.0; HIGHEST + 1];
    for (monomial, number) in polynomial.terms() {
        let power = monomial.exponent(coordinate).to_usize()?;
        if monomial.without(coordinate) != Monomial::one() {
            return None;
        }
        *coefficients.get_mut(power)? += to_f64(number);
    }
    while coefficients.last() == Some(&0.0) {
        coefficients.pop();
    }
    Some(coefficients)
}

/// Total variation of the argument of a sine or cosine along a grid.
fn variation(argument: &CompiledFunction, grid: &[f64]) -> f64 {
    let values: Vec<f64> = grid.iter().map(|&x| argument.call(&[x])).collect();
    let changes = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    changes.filter(|change| change.is_finite()).sum()
}

impl InnerFunction {
    fn features(&self, grid: &[f64]) -> Vec<Feature> {
        let levels: &[f64] = if self.kind == FunctionKind::Inverse { &[-1.0, 1.0] } else { &[0.0] };
        let (low, high) = (grid[0], grid[grid.len() - 1]);
        let mut places = match &self.polynomial {
            Some(coefficients) => {
                let zeros = real_zeros(&derivative(coefficients), [low, high]).into_iter();
                zeros.map(|zero| zero.place).collect()
            }
            None => zeros(&|x| self.slope.call(&[x]), grid),
        };
        // Between two neighbouring stationary points there is at most one zero.
        let mut separated = places.clone();
        match self.polynomial {
            Some(_) => separated.extend([low, high]),
            None => separated.extend(grid),
        }
        separated.sort_by(f64::total_cmp);
        for &level in levels {
            places.extend(zeros(&|x| self.argument.call(&[x]) - level, &separated));
        }
        let feature = |place: f64| {
            let width = self.width(place);
            Feature { place, width, singular: width == 0.0 && self.kind != FunctionKind::Corner }
        };
        places.into_iter().map(feature).filter(|feature| !feature.width.is_nan()).collect()
    }

    fn width(&self, place: f64) -> f64 {
        let [value, slope, curvature] = [&self.argument, &self.slope, &self.curvature]
            .map(|function| function.call(&[place]).abs());
        let change = match self.kind {
            FunctionKind::Corner | FunctionKind::Inverse => 0.0,
            FunctionKind::Scale { .. } => 1.0,
            FunctionKind::Power(exponent) => value / exponent,
        };
        // The smaller of the distances over which the linear and the quadratic part change that
        // much.
        let width = f64::min(change / slope, (2.0 * change / curvature).sqrt());
        match self.kind {
            FunctionKind::Corner | FunctionKind::Inverse => 0.0,
            _ if width.is_nan() => f64::min(0.0, width),
            _ => width,
        }
    }
}

/// The sign changes of a function between the points of a grid, and the points of the grid at which
/// it is zero.
fn zeros(function: &dyn Fn(f64) -> f64, grid: &[f64]) -> Vec<f64> {
    let mut found = Vec::new();
    let mut last: Option<(f64, f64)> = None;
    for &x in grid {
        let value = function(x);
        if !value.is_finite() {
            last = None;
            continue;
        }
        if value == 0.0 {
            // Of an interval on which the function is zero only the first point counts.
            if last.is_none_or(|(_, before)| before != 0.0) {
                found.push(x);
            }
        } else if let Some((before, value_before)) = last
            && value_before * value.signum() < 0.0
            && let Ok(zero) = find_root(function, before, x)
        {
            found.push(zero);
        }
        last = Some((x, value));
    }
    found
}

fn derivative(coefficients: &[f64]) -> Vec<f64> {
    coefficients.iter().enumerate().skip(1).map(|(k, c)| k as f64 * c).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;

    fn features(text: &str) -> Features {
        Features::new(&parse_expression(text).unwrap(), "x".into(), &BTreeMap::new())
    }

    fn has(found: &[Feature], place: f64, width: f64) -> bool {
        found.iter().any(|feature| {
            (feature.place - place).abs() < 1e-12 * (1.0 + place.abs())
                && (feature.width - width).abs() <= 1e-6 * width
        })
    }

    #[test]
    fn every_kind_of_place_is_found() {
        let cases: [(&str, f64, f64); 12] = [
            ("x - 1e5*(x + 1)*exp(-1e4*(x + 1)^2)", -1.0, 1e-2),
            ("x + 1e6*(x - 0.323)*H(x - 0.323)", 0.323, 0.0),
            ("x + (x - 0.3)^(3/2)*H(x - 0.3)", 0.3, 0.0),
            ("x + max(x - 1, 2*x - 1.25)", 0.25, 0.0),
            ("x + tanh(1e4*(x - 0.7))", 0.7, 1e-4),
            ("x + 1/(1e-8 + (x - 0.1)^2)", 0.1, 1e-4),
            ("x + (1 - x^2)^10000", 0.0, 1e-2),
            ("x + asin(sin(x))", 0.5 * std::f64::consts::PI, 0.0),
            // Two levels deep: the bump is where the sine is 0.6, and only there.
            ("x + exp(-1e12*(sin(x) - 0.6)^2)", 0.6_f64.asin(), 1e-6 / 0.8),
            ("x + abs(sin(500*x))", std::f64::consts::PI / 5.0, 0.0),
            ("x + H(exp(-1e6*(x - 0.2)^2) - 1/2)", 0.2 + 2.0_f64.ln().sqrt() * 1e-3, 0.0),
            ("x + abs((x - 0.1)*(x - 0.1000001)*(x + 3))", 0.100_000_1, 0.0),
        ];
        for (text, place, width) in cases {
            let found = features(text).between(-2.0, 2.0);
            assert!(has(&found, place, width), "{text}: {found:?}");
        }
    }

    #[test]
    fn what_is_smooth_is_not_cut() {
        for text in ["x + x^3", "sin(x)", "x/(1 + x^2)", "exp(x) - 1", "x*exp(-x^2)", "x^7 - x"] {
            assert_eq!(features(text).cuts(-1.0, 1.0), Vec::<f64>::new(), "{text}");
        }
        let cuts = features("x - 1e5*(x + 1)*exp(-1e4*(x + 1)^2)").cuts(-1.5, 2.0);
        assert!(cuts.contains(&-1.0) && cuts.len() < 20, "{cuts:?}");
    }

    #[test]
    fn a_zero_on_the_grid_is_one_zero() {
        let grid: Vec<f64> = (-4..=4).map(f64::from).collect();
        for (name, function, expected) in [
            ("falling", (|x: f64| 1.0 - x) as fn(f64) -> f64, vec![1.0]),
            ("rising", |x: f64| x + 2.0, vec![-2.0]),
            ("touching", |x: f64| x * x, vec![0.0]),
            ("resting", |x: f64| x.abs().max(1.0) - 1.0, vec![-1.0]),
            ("between", |x: f64| x - 0.5, vec![0.5]),
            ("broken", |x: f64| 1.0 / x, vec![]),
        ] {
            assert_eq!(zeros(&function, &grid), expected, "{name}");
        }
    }

    #[test]
    fn of_two_features_in_one_place_the_narrower_counts() {
        for text in
            ["abs(x - 1) + exp(-10000*(x - 1)^2)", "exp(-10000*(x - 1)^2) - exp(-1e8*(x - 1)^2)"]
        {
            let found = features(text).between(-2.0, 3.0);
            assert_eq!(found.len(), 1, "{found:?}");
            assert!(found[0].width < 2e-4, "{text}: {found:?}");
        }
    }

    #[test]
    fn numbers_stand_for_parameters() {
        let force = parse_expression("x + k*(x - xc)*H(x - xc) + x'").unwrap();
        let numbers = BTreeMap::from([("k".into(), 2.0), ("xc".into(), 1e-9)]);
        let found = Features::new(&force, "x".into(), &numbers).between(-1e-8, 1e-8);
        assert!(has(&found, 1e-9, 0.0), "{found:?}");
    }
}

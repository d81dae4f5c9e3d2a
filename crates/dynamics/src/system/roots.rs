//! Roots that begin at a corner, in a variable in which they are power series: Hertz's contact,
//! `max(x - d, 0)^(3/2)`, damping by a power of the velocity, `x^(1/3)`.
//!
//! In time such a force has no power series where its argument u is zero, and none whose steps would
//! not shrink beside it. It has one in s, with one w for each root that acts on this side of u = 0:
//!
//! ```text
//! u = sigma w^q,   sigma = 1 or -1,   dt = g ds,   g = product of w^(q-1)
//! abs(u)^(p/q) = w^p,   w' = sigma g/(q w^(q-1)) du/dt,   t' = g,   every other rate times g
//! ```
//!
//! The force is a polynomial in w, and contact begins and ends at simple zeros of w, however stiff
//! it is. (T. Levi-Civita and K. F. Sundman regularised collisions by this change of variable:
//! E. L. Stiefel, G. Scheifele, *Linear and Regular Celestial Mechanics*, Springer 1971.)

use std::collections::BTreeMap;

use num_integer::Integer as _;

use super::narrow::{FunctionGrowth, root_of_square};
use super::{System, rate_along};
use crate::exact::rational::{from_f64, ratio, to_f64};
use crate::expr::{Expr, ExprError, Function, Node};
use crate::series::guard::Guard;
use crate::symbol::{Symbol, fresh};

/// An expression u whose roots begin at zero, and the variable w in which they are powers.
#[derive(Clone, Debug)]
pub(super) struct Root {
    /// The expression u.
    argument: Expr,
    guard: Guard,
    /// The common denominator q of the exponents.
    degree: u32,
    /// The rate du/dt along the motion.
    rate: Expr,
    variable: Symbol,
}

impl Root {
    /// The value of u in these states; not a number where it has none.
    pub(super) fn argument_at(&self, system: &System, time: f64, states: &[f64]) -> f64 {
        let mut values = system.numbers.clone();
        values.extend(system.state.iter().copied().zip(states.iter().copied()));
        values.insert(system.time, time);
        self.argument.evaluate(&values).unwrap_or(f64::NAN)
    }

    /// The value of w in these states.
    pub(super) fn variable_at(&self, system: &System, time: f64, states: &[f64]) -> f64 {
        self.argument_at(system, time, states).abs().powf(1.0 / f64::from(self.degree))
    }
}

/// The equations of a system on one side of each of its roots.
#[derive(Clone, Debug)]
pub(super) struct Equations {
    /// The states, then w for each root that acts, then the time; without such a root the states
    /// alone.
    pub(super) states: Vec<Symbol>,
    /// The variable s, or the time.
    pub(super) variable: Symbol,
    /// The rates of the states.
    pub(super) right: Vec<Expr>,
    /// For each root the expression whose zero ends this side: w, or u if the root does not act.
    pub(super) ends: Vec<Expr>,
    pub(super) events: Vec<Expr>,
    pub(super) narrow: Vec<(Expr, FunctionGrowth)>,
    /// The roots that act.
    pub(super) acting: Vec<usize>,
}

impl Equations {
    /// The equations of a system with all roots as they are.
    pub(super) fn as_written(system: &System, events: &[&Expr]) -> Self {
        let narrow = system.narrow.iter();
        Self {
            states: system.state.clone(),
            variable: system.time,
            right: system.right.clone(),
            ends: vec![],
            events: events.iter().map(|event| (*event).clone()).collect(),
            narrow: narrow.map(|argument| (argument.expression.clone(), argument.kind)).collect(),
            acting: vec![],
        }
    }
}

/// One root in an expression: `factor abs(u)^(p/q)`, or with the sign of u.
struct Occurrence {
    argument: Expr,
    factor: Expr,
    exponent: [u32; 2],
    is_odd: bool,
}

/// Returns a node as a root that begins at zero; `None` for any other node.
fn occurrence(node: &Expr, numbers: &BTreeMap<Symbol, f64>) -> Option<Occurrence> {
    let Node::Power(base, exponent) = node.node() else { return None };
    if let Some(argument) = root_of_square(base, numbers) {
        let exponent_of_root = fraction(2.0 * exponent.evaluate(numbers).ok()?)?;
        let square = argument.integer_power(2).ok()?;
        let factor = Expr::divide(base, &square).ok()?;
        let factor = Expr::power(&factor, exponent).ok()?;
        factor.evaluate(numbers).ok().filter(|factor| factor.is_finite())?;
        let argument = argument.clone();
        return Some(Occurrence { argument, factor, exponent: exponent_of_root, is_odd: false });
    }
    // A real root of odd degree goes on below zero.
    let exact = exponent.as_number().filter(|exponent| exponent.denom().is_odd())?;
    let [numerator, denominator] = fraction(to_f64(exact))?;
    Some(Occurrence {
        argument: base.clone(),
        factor: Expr::one(),
        exponent: [numerator, denominator],
        is_odd: numerator % 2 == 1,
    })
}

/// Returns a positive exponent as a fraction with a small denominator of at least 2; `None` if it
/// is none.
fn fraction(exponent: f64) -> Option<[u32; 2]> {
    const LARGEST: u32 = 8;
    const LARGEST_EXPONENT: f64 = 16.0;
    const ROUNDING: f64 = 1e-13;
    let is_near = |denominator: &u32| {
        let numerator = exponent * f64::from(*denominator);
        (numerator - numerator.round()).abs() <= ROUNDING * numerator
    };
    let denominator = (1..=LARGEST).find(is_near)?;
    let is_root = exponent > 0.0 && exponent <= LARGEST_EXPONENT && denominator > 1;
    is_root.then(|| [(exponent * f64::from(denominator)).round() as u32, denominator])
}

/// Finds the roots in the right sides and events whose arguments move with the states; none if the
/// rate of one of them cannot be written, or the powers of w would be too high to gain by them.
pub(super) fn corner_roots(system: &System, events: &[&Expr]) -> Vec<Root> {
    const HIGHEST: u32 = 24;
    let expressions = system.right.iter().chain(events.iter().copied());
    let mut found: Vec<Root> = Vec::new();
    let mut taken: Vec<Symbol> = system.state.iter().chain([&system.time]).copied().collect();
    taken.extend(system.numbers.keys());
    for node in expressions.flat_map(Expr::unique_nodes) {
        let Some(Occurrence { argument, exponent, .. }) = occurrence(node, &system.numbers) else {
            continue;
        };
        let moves = system.state.iter().any(|state| argument.contains(*state));
        if !moves {
            continue;
        }
        let argument = inside_corner(&argument, &system.numbers).unwrap_or(argument);
        let guard = Guard::new(&argument, &system.numbers);
        if let Some(known) = found.iter_mut().find(|root| guard.ratio_to(&root.guard).is_some()) {
            known.degree = known.degree.lcm(&exponent[1]);
            if known.degree > HIGHEST {
                return vec![];
            }
            continue;
        }
        let Some(rate) = is_smooth(&argument)
            .then(|| rate_along(&argument, system.time, &system.state, &system.right))
            .flatten()
        else {
            return vec![];
        };
        let variable = fresh("w", &taken);
        taken.push(variable);
        found.push(Root { argument, guard, degree: exponent[1], rate, variable });
    }
    found
}

/// Returns u for a number times `abs(u)`, `max(u, 0)` or `min(u, 0)`; `None` for any other
/// expression.
fn inside_corner(expression: &Expr, numbers: &BTreeMap<Symbol, f64>) -> Option<Expr> {
    let is_number = |factor: &&Expr| factor.symbols().iter().all(|name| numbers.contains_key(name));
    let (_, factors) = expression.factors();
    let mut others = factors.iter().filter(|factor| !is_number(factor));
    let (Some(only), None) = (others.next(), others.next()) else { return None };
    match only.node() {
        Node::Function(Function::Absolute, arguments) => arguments.first().cloned(),
        Node::Function(Function::Maximum | Function::Minimum, arguments) => {
            arguments.iter().find(|argument| argument.is_zero())?;
            arguments.iter().find(|argument| !argument.is_zero()).cloned()
        }
        _ => None,
    }
}

/// Whether an expression has neither corners nor roots.
fn is_smooth(expression: &Expr) -> bool {
    if expression.contains_corner() {
        return false;
    }
    expression.unique_nodes().all(|node| match node.node() {
        Node::Power(_, exponent) => exponent.as_number().is_some_and(|number| number.is_integer()),
        _ => true,
    })
}

/// The symbols in the corners of an expression, and in its powers that are not whole: other numbers
/// for these may make other roots.
pub(super) fn fixed_symbols(expression: &Expr) -> impl Iterator<Item = Symbol> {
    let nodes = expression.unique_nodes().filter(|node| match node.node() {
        Node::Power(_, exponent) => exponent.as_number().is_none_or(|number| !number.is_integer()),
        Node::Function(function, _) => function.has_corner(),
        _ => false,
    });
    nodes.flat_map(|node| node.symbols())
}

/// Writes the equations of a system where the arguments of its roots have these signs.
///
/// # Errors
/// [`ExprError`] if an expression becomes too large.
pub(super) fn equations_on_side(
    system: &System,
    events: &[&Expr],
    roots: &[Root],
    signs: &[f64],
) -> Result<Equations, ExprError> {
    let sided = |expression: &Expr| on_side(expression, roots, signs, &system.numbers);
    let right = system.right.iter().map(sided).collect::<Result<Vec<_>, _>>()?;
    let events = events.iter().map(|event| sided(event)).collect::<Result<Vec<_>, _>>()?;
    let nodes = right.iter().chain(&events).flat_map(Expr::unique_nodes);
    let left = nodes.filter_map(|node| occurrence(node, &system.numbers));
    let left: Vec<Guard> =
        left.map(|occurrence| Guard::new(&occurrence.argument, &system.numbers)).collect();
    let acts = |root: &Root| left.iter().any(|guard| guard.ratio_to(&root.guard).is_some());
    let acting: Vec<usize> = (0..roots.len()).filter(|index| acts(&roots[*index])).collect();
    let in_powers = |expression: &Expr| {
        let roots = acting.iter().map(|index| (&roots[*index], signs[*index]));
        in_powers(expression, &roots.collect::<Vec<_>>(), &system.numbers)
    };
    let is_of_root = |argument: &Expr| {
        let guard = Guard::new(argument, &system.numbers);
        roots.iter().any(|root| guard.ratio_to(&root.guard).is_some())
    };
    let narrow = system.narrow.iter().filter(|argument| {
        !(matches!(argument.kind, FunctionGrowth::Power(_)) && is_of_root(&argument.expression))
    });
    let narrow =
        narrow.map(|argument| Ok((in_powers(&sided(&argument.expression)?)?, argument.kind)));
    let mut equations = Equations {
        states: system.state.clone(),
        variable: system.time,
        right,
        ends: roots.iter().map(|root| root.argument.clone()).collect(),
        events,
        narrow: narrow.collect::<Result<_, ExprError>>()?,
        acting: acting.clone(),
    };
    if acting.is_empty() {
        return Ok(equations);
    }
    // g, and g without the factor of one root.
    let factors = |without: Option<usize>| {
        let others = acting.iter().filter(|index| Some(**index) != without);
        let factors = others.map(|index| {
            let Root { variable, degree, .. } = &roots[*index];
            Expr::from(*variable).integer_power(i64::from(*degree) - 1)
        });
        factors.collect::<Result<Vec<_>, _>>().map(Expr::product)
    };
    let clock = factors(None)?;
    let mut rates = Vec::new();
    for right in &equations.right {
        rates.push(&clock * &in_powers(right)?);
    }
    for index in &acting {
        let Root { rate, degree, .. } = &roots[*index];
        let inwards = Expr::number(ratio(signs[*index] as i64, i64::from(*degree)));
        rates.push(inwards * &(factors(Some(*index))? * &in_powers(&sided(rate)?)?));
        let variable = roots[*index].variable;
        equations.states.push(variable);
        equations.ends[*index] = Expr::from(variable);
    }
    rates.push(clock);
    equations.states.push(system.time);
    equations.right = rates;
    equations.events = equations.events.iter().map(in_powers).collect::<Result<Vec<_>, _>>()?;
    let taken: Vec<Symbol> =
        equations.states.iter().chain(system.numbers.keys()).copied().collect();
    equations.variable = fresh("s", &taken);
    Ok(equations)
}

/// Writes an expression for one side of each root: corners at u = 0 are those of that side.
fn on_side(
    expression: &Expr,
    roots: &[Root],
    signs: &[f64],
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Expr, ExprError> {
    let is_positive = |argument: &Expr| {
        let guard = Guard::new(argument, numbers);
        let mut sides = roots.iter().zip(signs);
        sides.find_map(|(root, sign)| Some(guard.ratio_to(&root.guard)? * sign > 0.0))
    };
    expression.fold(|expr, children: &[Expr]| {
        let Node::Function(function, arguments) = expr.node() else {
            return expr.with_children(children);
        };
        let on_side = match (function, arguments.as_slice(), children) {
            (Function::Step, [argument], _) => {
                is_positive(argument).map(|positive| Expr::from(i64::from(positive)))
            }
            (Function::Sign, [argument], _) => {
                is_positive(argument).map(|positive| Expr::from(if positive { 1 } else { -1 }))
            }
            (Function::Absolute, [argument], [inner]) => {
                is_positive(argument).map(|positive| if positive { inner.clone() } else { -inner })
            }
            (Function::Maximum | Function::Minimum, [one, other], [first, second]) => {
                let takes_first = |positive| positive == (*function == Function::Maximum);
                let choose = |positive| if takes_first(positive) { first } else { second };
                is_positive(&(one - other)).map(|positive| choose(positive).clone())
            }
            _ => None,
        };
        on_side.map_or_else(|| expr.with_children(children), Ok)
    })
}

/// Writes the roots of an expression as powers of their variables.
fn in_powers(
    expression: &Expr,
    roots: &[(&Root, f64)],
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Expr, ExprError> {
    expression.fold(|expr, children: &[Expr]| {
        let Some(occurrence) = occurrence(expr, numbers) else {
            return expr.with_children(children);
        };
        let guard = Guard::new(&occurrence.argument, numbers);
        let found =
            roots.iter().find_map(|(root, sign)| Some((root, sign, guard.ratio_to(&root.guard)?)));
        let Some((root, sign, ratio)) = found else { return expr.with_children(children) };
        let [numerator, denominator] = occurrence.exponent;
        let power = Expr::from(root.variable)
            .integer_power(i64::from(numerator * (root.degree / denominator)))?;
        let size = ratio.abs().powf(f64::from(numerator) / f64::from(denominator));
        let signed = if occurrence.is_odd && ratio * sign < 0.0 { -size } else { size };
        match from_f64(signed) {
            Some(signed) => Ok(Expr::number(signed) * &(&occurrence.factor * &power)),
            None => expr.with_children(children),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::ode::quadrature::integrate_smooth;
    use crate::system::{Integrator, Path, PathEnd, SystemOptions, solve_together};

    const CONTACT: [(&str, &str); 2] = [("x", "v"), ("v", "-k*max(x, 0)^(3/2)")];

    fn path(equations: &[(&str, &str)], numbers: &[(&str, f64)], start: &[f64], end: f64) -> Path {
        let system = System::parse(equations, numbers).expect("a system");
        let path = system.solve([0.0, end], start, &[], &SystemOptions::default()).expect("a path");
        assert_eq!(path.reason(), PathEnd::Reached);
        path
    }

    /// A mass of one that meets `k u^(3/2)` with the speed one goes in by `(5/(4 k))^(2/5)`, and stays
    /// for `4 integral_0^1 y dy/sqrt(1 - (1 - y^2)^(5/2))` times that.
    #[test]
    fn contact_lasts_as_long_as_the_energy_says_however_stiff_it_is() {
        let inverse_speed = |y: f64| y / (-(2.5 * (-y * y).ln_1p()).exp_m1()).sqrt();
        let (integral, _) = integrate_smooth(inverse_speed, 0.0, 1.0, 1e-14).expect("an integral");
        let unit = 4.0 * integral;
        let mut steps = Vec::new();
        for k in [1.0_f64, 1e3, 1e6, 1e9, 1e12] {
            let deepest = (1.25 / k).powf(0.4);
            let path = path(&CONTACT, &[("k", k)], &[-1.0, 1.0], 3.0 + unit * deepest);
            let [x, v] = path.states_at(path.end()).expect("a state")[..] else { panic!() };
            assert!((x + 2.0).abs() < 1e-13 && (v + 1.0).abs() < 1e-13, "{k}: {x} {v}");
            let middle = path.states_at(1.0 + 0.5 * unit * deepest).expect("a state");
            assert!((middle[0] / deepest - 1.0).abs() < 1e-9, "{k}: {middle:?}");
            steps.push(path.step_count());
        }
        assert!(steps.iter().all(|count| *count < 30), "{steps:?}");
    }

    #[test]
    fn a_root_goes_on_below_zero() {
        let path = path(&[("x", "v"), ("v", "-x^(1/3)")], &[], &[1.0, 0.0], 100.0);
        let zeros = path.zeros(0, 0.0).expect("series");
        assert!(zeros.len() > 15);
        for (index, zero) in zeros.iter().enumerate() {
            let quarters = (2 * index + 1) as f64;
            assert!((zero / (quarters * zeros[0]) - 1.0).abs() < 1e-14, "{index}: {zero}");
        }
        let mut sampled = vec![vec![]; 2];
        let times: Vec<f64> = (0..=1000).map(|index| 0.1 * f64::from(index)).collect();
        path.sample(&times, &mut vec![], &mut sampled);
        for (x, v) in sampled[0].iter().zip(&sampled[1]) {
            let energy = 0.5 * v * v + 0.75 * x.abs().powf(4.0 / 3.0);
            assert!((energy - 0.75).abs() < 1e-13, "{x} {v}");
        }
    }

    /// Evaluation alone, which knows nothing of roots, gives the same motion.
    #[test]
    fn roots_of_velocities_and_of_both_sides_and_in_products_are_those_of_evaluation() {
        let numbers = [("n", 1.5), ("d", 0.25)];
        for (equation, start) in [
            ("-x - (v^2)^(n/2)*sgn(v)/5", [1.0, 0.0]),
            ("-x^3 - 40*((x - d)^2)^(n/2)*H(x - d)*(1 + v/3) - v/20", [-1.0, 0.0]),
            ("-x - 7*((x - d)^2)^(3/4)*H(x - d) + 5*((-x - d)^2)^(5/8)*H(-x - d)", [0.1, 0.5]),
            ("-((2*x)^2)^(3/4)*sgn(x) + cos(3*t)/7", [0.7, 0.1]),
            (
                "-x - 3*abs(x - d)^(4/3)*sgn(x - d) - 2*max(-x, 0)^(6/5) - abs(v)^(7/5)/9",
                [1.0, 0.0],
            ),
            ("-x - 3*max(0, x - d) - ((x - d)^2)^(5/4)*H(2*x - 2*d)", [0.0, 1.0]),
        ] {
            let system = System::parse(&[("x", "v"), ("v", equation)], &numbers).expect(equation);
            let options = [Integrator::Taylor, Integrator::RungeKutta]
                .map(|integrator| SystemOptions { integrator, ..SystemOptions::default() });
            let [by_series, by_evaluation] = options.map(|options| {
                let path = system.solve([0.0, 20.0], &start, &[], &options).expect(equation);
                assert_eq!(path.reason(), PathEnd::Reached, "{equation}");
                path.states_at(20.0).expect("a state")
            });
            for (one, other) in by_series.iter().zip(&by_evaluation) {
                assert!((one - other).abs() < 1e-10, "{equation}: {one} {other}");
            }
        }
    }

    #[test]
    fn motions_side_by_side_are_those_alone() {
        let system = System::parse(&CONTACT, &[("k", 10.0)]).expect("a system");
        let solver = system.solver(&[], &SystemOptions::default());
        let solvers: Vec<_> = (2..13)
            .map(|k| solver.with_numbers(&[("k".into(), f64::from(k))].into()).expect("the same"))
            .collect();
        let motions: Vec<_> = solvers
            .iter()
            .enumerate()
            .map(|(index, solver)| (solver, [0.0, 5.0 + index as f64], &[-1.0, 1.0][..]))
            .collect();
        let together = solve_together(&motions);
        for ((solver, times, start), together) in motions.into_iter().zip(together) {
            let alone = solver.solve(times, start).expect("a path");
            assert_eq!(alone.states_at(times[1]), together.expect("a path").states_at(times[1]));
        }
    }

    /// Four spheres in a row, of which the first strikes the next: contacts overlap.
    #[test]
    fn a_row_of_spheres_keeps_energy_and_momentum() {
        let contact = |one: char, other: char| {
            format!("((x{one} - x{other})^2)^(3/4)*H(x{one} - x{other})*1000")
        };
        let [first, second, third] =
            [('a', 'b'), ('b', 'c'), ('c', 'd')].map(|(one, other)| contact(one, other));
        let accelerations = [
            format!("-{first}"),
            format!("{first} - {second}"),
            format!("{second} - {third}"),
            third,
        ];
        let names = ["a", "b", "c", "d"].map(|body| (format!("x{body}"), format!("v{body}")));
        let places = names.iter().map(|(place, speed)| (place.as_str(), speed.as_str()));
        let speeds = names.iter().map(|(_, speed)| speed.as_str());
        let equations: Vec<_> =
            places.chain(speeds.zip(accelerations.iter().map(String::as_str))).collect();
        let end = 0.2;
        let path = path(&equations, &[], &[0.0, 0.0, 0.01, 0.02, 1.0, 0.0, 0.0, 0.0], end);
        for time in [0.05, 0.1, 0.15, end] {
            let state = path.states_at(time).expect("a state");
            let (places, speeds) = state.split_at(4);
            let depths = places.windows(2).map(|pair| (pair[0] - pair[1]).max(0.0));
            let pressed: f64 = depths.map(|depth| 400.0 * depth.powf(2.5)).sum();
            let moving: f64 = speeds.iter().map(|speed| 0.5 * speed * speed).sum();
            assert!((pressed + moving - 0.5).abs() < 1e-13, "{time}: {pressed} {moving}");
            assert!((speeds.iter().sum::<f64>() - 1.0).abs() < 1e-13, "{time}: {speeds:?}");
        }
    }

    /// From the corner itself, inwards and outwards.
    #[test]
    fn a_motion_may_begin_at_a_corner() {
        for (speed, end) in [(1.0, -1.0), (-1.0, -1.0)] {
            let path = path(&CONTACT, &[("k", 1e4)], &[0.0, speed], 5.0);
            assert!((path.states_at(5.0).expect("a state")[1] - end).abs() < 1e-13);
        }
    }

    #[test]
    fn small_fractions_alone_are_roots() {
        for (exponent, expected) in [
            (1.5, Some([3, 2])),
            (1.2, Some([6, 5])),
            (1.0 / 3.0, Some([1, 3])),
            (2.0, None),
            (1.2345, None),
            (-0.5, None),
            (f64::NAN, None),
        ] {
            assert_eq!(fraction(exponent), expected, "{exponent}");
        }
    }
}

//! Rates that jump, by `sgn` and `H`, with a symbol for the side of each surface on which they do.
//!
//! ```text
//! y' = f(y, t; p, s_1, s_2, ...),   s_i = sgn(u_i(y, t; p)),   H(u_i) = (1 + s_i)/2
//! du_i/dt = g_i(y, t; p, s) = u_t + u_y f
//! ```
//!
//! A motion can stay on a surface where du_i/dt depends on s_i. What depends on s_i in any other way
//! than linearly, as `H(u)^2`, is the linear function with the same values on both sides, so that in
//! between it is Filippov's convex combination. Of the product of two such surfaces there is no one
//! combination where they meet: it is refused.
//!
//! In: right sides as expressions. Out: f, g and u with their derivatives, compiled.

use std::cell::RefCell;
use std::collections::BTreeMap;

use nalgebra::DMatrix;

use crate::exact::rational::to_f64;
use crate::expr::{CompiledFunction, CompiledList, Expr, Function, Node, PreparedList};
use crate::response::ResponseError;
use crate::series::guard::Guards;
use crate::symbol::{Symbol, fresh_stem};

/// A matrix of expressions of which few entries are not zero, compiled.
#[derive(Clone, Debug)]
pub(super) struct Table {
    shape: (usize, usize),
    places: Vec<(usize, usize)>,
    entries: CompiledList,
    /// All entries as one list with memory for their values, which calls share.
    prepared: RefCell<PreparedList>,
}

impl Table {
    /// Compiles rows of equal length in these arguments.
    ///
    /// # Errors
    /// [`ResponseError`] for another name.
    pub(super) fn new(rows: &[Vec<Expr>], arguments: &[Symbol]) -> Result<Self, ResponseError> {
        let (mut places, mut entries) = (Vec::new(), Vec::new());
        for (i, row) in rows.iter().enumerate() {
            for (j, entry) in row.iter().enumerate().filter(|(_, entry)| !entry.is_zero()) {
                places.push((i, j));
                entries.push(entry.clone());
            }
        }
        let shape = (rows.len(), rows.first().map_or(0, Vec::len));
        let entries = CompiledList::new(&entries, arguments)?;
        let prepared = RefCell::new(PreparedList::new(&entries));
        Ok(Self { shape, places, entries, prepared })
    }

    /// Calls a function with the place and the value of each entry that is not zero throughout.
    pub(super) fn visit(&self, arguments: &[f64], mut visit: impl FnMut((usize, usize), f64)) {
        let values = &mut *self.prepared.borrow_mut();
        values.call(arguments);
        for (index, place) in self.places.iter().enumerate() {
            visit(*place, values.value(index));
        }
    }

    /// The number of rows.
    pub(super) fn rows(&self) -> usize {
        self.shape.0
    }

    /// The places and the list of the entries in the first columns that are not zero throughout, where the
    /// arguments from one on have these values.
    pub(super) fn specialised(
        &self,
        columns: usize,
        first: usize,
        values: &[f64],
    ) -> (Vec<(usize, usize)>, CompiledList) {
        let is_kept = |index: usize| self.places[index].1 < columns;
        let places = self.places.iter().copied().filter(|(_, column)| *column < columns).collect();
        (places, self.entries.specialised(is_kept, first, values))
    }

    /// The matrix at these arguments.
    pub(super) fn at(&self, arguments: &[f64]) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(self.shape.0, self.shape.1);
        self.visit(arguments, |place, value| matrix[place] = value);
        matrix
    }
}

/// An event in the time of a flow, at which states jump: the impact on a rigid wall, or another one.
#[derive(Clone, Debug)]
pub(super) struct FlowEvent {
    /// The gap in the states, the time and the parameter: the event is where it falls through zero.
    pub(super) gap: Expr,
    /// All states after the event.
    pub(super) after: Vec<Expr>,
    /// Whether no motion is behind it, as behind a wall.
    pub(super) is_wall: bool,
    /// The direction in which a wall pushes, M^-1 n, of each coordinate.
    pub(super) push: Option<Vec<Expr>>,
}

/// The motion that rests on a wall, compiled; the arguments are those of the rates.
#[derive(Clone, Debug)]
pub(super) struct RestMap {
    /// dg/dt.
    pub(super) rate: CompiledFunction,
    /// Its derivatives by the states, by the parameter and by the time.
    pub(super) normal: Table,
    /// The derivative of dg/dt by the time where nothing rests.
    pub(super) acceleration: CompiledFunction,
    /// The directions in which the wall pushes the places and the velocities, a row each.
    pub(super) directions: Table,
    /// f on the wall.
    pub(super) rates: Table,
    /// f, f_y, f_p, a row for each state.
    pub(super) varied: Table,
}

/// An event, compiled; the arguments are those of the rates.
#[derive(Clone, Debug)]
pub(super) struct EventMap {
    /// The gap g, as it was given and compiled.
    pub(super) expression: Expr,
    pub(super) gap: CompiledFunction,
    /// g_y, g_p, g_t in one row.
    pub(super) normal: Table,
    /// The states R after the event, R_y, R_p, R_t, a row for each state.
    pub(super) after: Table,
    /// Whether no motion is behind it, as behind a wall.
    pub(super) is_wall: bool,
    /// The duration at both ends of a run within which it does not take place, as where a run begins and
    /// ends with a grazing.
    pub(super) unwatched: f64,
    /// The motion that rests on it, on a wall where no force jumps.
    pub(super) rest: Option<RestMap>,
}

/// Rates with the surfaces across which they jump and the events at which states do, compiled. The
/// arguments of all functions are the states, the time, the parameter, then the side of each surface.
#[derive(Clone, Debug)]
pub(super) struct JumpSurfaces {
    /// The number of states.
    pub(super) states: usize,
    /// The arguments u of the jumps.
    pub(super) arguments: Vec<Expr>,
    /// Whether the rates on one side of all surfaces, and the arguments, have no corner.
    pub(super) smooth: bool,
    /// Whether u of each surface is a constant and a sum of the states, each times a constant.
    pub(super) is_linear: Vec<bool>,
    /// Whether a motion can stay on each surface, because du/dt depends on its side.
    pub(super) holds: Vec<bool>,
    /// The factors c of the states where u = d/dt (c y), so that c y stays what it is on the surface; `None`
    /// where u is no such rate.
    pub(super) places: Vec<Option<Vec<f64>>>,
    /// u of each surface.
    pub(super) heights: Vec<CompiledFunction>,
    /// u_y, then u_p, a row for each surface.
    pub(super) normals: Table,
    /// f.
    pub(super) rates: Table,
    /// f, f_y, f_p, then f_s, a row for each state.
    pub(super) varied: Table,
    /// g, then g_s, a row for each surface.
    pub(super) rises: Table,
    /// g_y, then g_p.
    pub(super) varied_rises: Table,
    /// The impacts on rigid walls and the other events.
    pub(super) events: Vec<EventMap>,
}

impl JumpSurfaces {
    /// Finds the surfaces of right sides in the states, the time and the parameter; `None` if nothing
    /// jumps, neither a rate nor a state.
    ///
    /// # Errors
    /// [`ResponseError::CoupledJump`] for a product of jumps that a motion can both stay on;
    /// [`ResponseError`] for a derivative that cannot be written.
    pub(super) fn new(
        states: &[Symbol],
        time: Symbol,
        right: &[Expr],
        parameter: Symbol,
        events: &[FlowEvent],
    ) -> Result<Option<Self>, ResponseError> {
        let known: Vec<Symbol> = states.iter().copied().chain([time, parameter]).collect();
        let stem = fresh_stem("side", &known);
        let mut sides =
            Sides { stem, guards: Guards::new(&BTreeMap::new()), arguments: Vec::new() };
        for part in right.iter().flat_map(|rate| rate.unique_nodes()) {
            if let Some(argument) = jump_of(part) {
                sides.find(argument);
            }
        }
        let count = sides.arguments.len();
        if count == 0 && events.is_empty() {
            return Ok(None);
        }
        let names: Vec<Symbol> = (0..count).map(|index| sides.name(index)).collect();
        let mut rates = Vec::new();
        for rate in right {
            let mut rate = sides.written(rate)?;
            for name in &names {
                rate = linear_in(rate, *name)?;
            }
            rates.push(rate);
        }
        let slope = |expression: &Expr, by: Symbol| -> Result<Expr, ResponseError> {
            Ok(match expression.contains(by) {
                true => expression.differentiate(by)?,
                false => Expr::zero(),
            })
        };
        let slopes = |expression: &Expr, by: &[Symbol]| -> Result<Vec<Expr>, ResponseError> {
            by.iter().map(|by| slope(expression, *by)).collect()
        };
        let mut rises = Vec::new();
        for argument in &sides.arguments {
            let mut parts = vec![slope(argument, time)?];
            for (state, rate) in states.iter().zip(&rates) {
                parts.push(slope(argument, *state)? * rate);
            }
            rises.push(Expr::sum(parts));
        }
        let mut holds = Vec::new();
        for (rise, name) in rises.iter().zip(&names) {
            let by_side = slope(rise, *name)?;
            holds.push(!by_side.is_zero() && !by_side.expand()?.is_zero());
        }
        let mut is_linear = Vec::new();
        for argument in &sides.arguments {
            let slopes = slopes(argument, states)?;
            let is_constant =
                |slope: &Expr| !known[..=states.len()].iter().any(|name| slope.contains(*name));
            is_linear.push(!argument.contains(time) && slopes.iter().all(is_constant));
        }
        let mut places = Vec::new();
        for argument in &sides.arguments {
            places.push(place_of(argument, states)?);
        }
        let holding: Vec<usize> = (0..count).filter(|index| holds[*index]).collect();
        for (index, rate) in rates.iter().enumerate() {
            for one in &holding {
                let by_one = slope(rate, names[*one])?.expand()?;
                let second =
                    holding.iter().find(|other| *other != one && by_one.contains(names[**other]));
                if let Some(other) = second {
                    let jumps = [*one, *other].map(|index| &sides.arguments[index]);
                    return Err(ResponseError::CoupledJump(product_of(&right[index], jumps)));
                }
            }
        }
        let with_parameter: Vec<Symbol> = states.iter().copied().chain([parameter]).collect();
        let all: Vec<Symbol> = known.iter().chain(&names).copied().collect();
        let table = |rows: &[Expr], own: bool, by: &[&[Symbol]]| -> Result<Table, ResponseError> {
            let row = |expression: &Expr| -> Result<Vec<Expr>, ResponseError> {
                let mut row = if own { vec![expression.clone()] } else { vec![] };
                for by in by {
                    row.extend(slopes(expression, by)?);
                }
                Ok(row)
            };
            let rows: Vec<Vec<Expr>> = rows.iter().map(row).collect::<Result<_, _>>()?;
            Table::new(&rows, &all)
        };
        let by_all: Vec<Symbol> = states.iter().copied().chain([parameter, time]).collect();
        // The derivative of a function along a motion with these rates.
        let along = |function: &Expr| -> Result<Expr, ResponseError> {
            let mut parts = vec![slope(function, time)?];
            for (state, rate) in states.iter().zip(&rates) {
                parts.push(slope(function, *state)? * rate);
            }
            Ok(Expr::sum(parts))
        };
        let rest = |gap: &Expr, push: &[Expr]| -> Result<RestMap, ResponseError> {
            let rate = along(gap)?;
            let acceleration = along(&rate)?;
            let of_places = |index: usize| push.get(index).cloned().unwrap_or_else(Expr::zero);
            let of_velocities = |index: usize| {
                let is_own = |place: &Symbol| place.derivative() == states[index];
                let place = states[..push.len()].iter().position(is_own);
                place.map_or_else(Expr::zero, |place| push[place].clone())
            };
            let indices = 0..states.len();
            let places: Vec<Expr> = indices.clone().map(of_places).collect();
            let velocities: Vec<Expr> = indices.map(of_velocities).collect();
            let mut closing = Vec::new();
            for (state, push) in states.iter().zip(&velocities) {
                closing.push(slope(&rate, *state)? * push);
            }
            let force = Expr::divide(&acceleration, &Expr::sum(closing))?;
            let on_wall = rates.iter().zip(&velocities).map(|(rate, push)| rate - &(push * &force));
            let on_wall: Vec<Expr> = on_wall.collect();
            Ok(RestMap {
                rate: CompiledFunction::new(&rate, &all)?,
                normal: table(std::slice::from_ref(&rate), false, &[&by_all])?,
                acceleration: CompiledFunction::new(&acceleration, &all)?,
                directions: Table::new(&[places, velocities], &all)?,
                rates: table(&on_wall, true, &[])?,
                varied: table(&on_wall, true, &[&with_parameter])?,
            })
        };
        let event = |event: &FlowEvent| -> Result<EventMap, ResponseError> {
            Ok(EventMap {
                expression: event.gap.clone(),
                gap: CompiledFunction::new(&event.gap, &all)?,
                normal: table(std::slice::from_ref(&event.gap), false, &[&by_all])?,
                after: table(&event.after, true, &[&by_all])?,
                is_wall: event.is_wall,
                unwatched: 0.0,
                rest: match &event.push {
                    Some(push) if count == 0 => Some(rest(&event.gap, push)?),
                    _ => None,
                },
            })
        };
        Ok(Some(Self {
            states: states.len(),
            events: events.iter().map(event).collect::<Result<_, _>>()?,
            heights: sides
                .arguments
                .iter()
                .map(|argument| CompiledFunction::new(argument, &all))
                .collect::<Result<_, _>>()?,
            normals: table(&sides.arguments, false, &[&with_parameter])?,
            rates: table(&rates, true, &[])?,
            varied: table(&rates, true, &[&with_parameter, &names])?,
            rises: table(&rises, true, &[&names])?,
            varied_rises: table(&rises, false, &[&with_parameter])?,
            smooth: !rates.iter().chain(&sides.arguments).any(Expr::contains_corner),
            arguments: sides.arguments,
            is_linear,
            holds,
            places,
        }))
    }

    /// Whether nothing jumps where the rate of a coordinate is zero, or that of a velocity at its largest
    /// value.
    pub(super) fn has_smooth_turn(&self, states: &[Symbol], state: usize) -> bool {
        let is_alone = |place: &[f64], state: usize| {
            place.iter().enumerate().all(|(index, factor)| (index == state) == (*factor != 0.0))
        };
        let of_velocity = states.iter().position(|name| name.derivative() == states[state]);
        self.arguments.iter().zip(&self.places).all(|(argument, place)| {
            match (of_velocity, place) {
                (None, None) => true,
                (None, Some(place)) => !is_alone(place, state),
                (Some(_), _) if !argument.contains(states[state]) => true,
                (Some(coordinate), Some(place)) => is_alone(place, coordinate),
                (Some(_), None) => false,
            }
        })
    }

    /// The sums of states that stay what they are on these surfaces, by their factors, each reduced by
    /// those before and with its largest factor one.
    pub(super) fn places_on(&self, surfaces: &[usize]) -> Vec<Vec<f64>> {
        const NOTHING: f64 = 1e-9;
        let mut found: Vec<Vec<f64>> = Vec::new();
        for place in surfaces.iter().filter_map(|index| self.places[*index].as_ref()) {
            let mut left = place.clone();
            for known in &found {
                let factor = left[largest(known)];
                left.iter_mut().zip(known).for_each(|(one, other)| *one -= factor * other);
            }
            let size = left[largest(&left)];
            if size.abs() > NOTHING * place[largest(place)].abs() {
                found.push(left.iter().map(|factor| factor / size).collect());
            }
        }
        found
    }
}

/// The index of the largest factor.
pub(super) fn largest(factors: &[f64]) -> usize {
    let size = |index: &usize| factors[*index].abs();
    (0..factors.len()).max_by(|one, other| size(one).total_cmp(&size(other))).unwrap_or(0)
}

/// The surfaces found so far, with the names of their sides.
struct Sides {
    stem: String,
    guards: Guards,
    arguments: Vec<Expr>,
}

impl Sides {
    fn name(&self, index: usize) -> Symbol {
        Symbol::new(&format!("{}{index}", self.stem))
    }

    /// The number of the surface of an argument, and whether the argument has the sign of its u.
    fn find(&mut self, argument: &Expr) -> (usize, bool) {
        let guard = self.guards.find_or_add(argument);
        if guard.is_new {
            self.arguments.push(argument.clone());
        }
        (guard.index, guard.is_aligned)
    }

    /// A rate with the sides in place of its jumps, and of the corners of `abs` on the same surfaces.
    fn written(&self, rate: &Expr) -> Result<Expr, ResponseError> {
        let written = |expr: &Expr, children: &[Expr]| match (expr.node(), children) {
            (
                Node::Function(
                    function @ (Function::Sign | Function::Step | Function::Absolute),
                    arguments,
                ),
                [child],
            ) => {
                let guard = self.guards.clone().find_or_add(&arguments[0]);
                // No other corner than those of the surfaces is a new guard.
                if guard.is_new {
                    return expr.with_children(children);
                }
                let side = Expr::from(self.name(guard.index));
                let side = if guard.is_aligned { side } else { -side };
                match function {
                    Function::Sign => Ok(side),
                    Function::Step => Expr::divide(&(Expr::one() + side), &Expr::from(2)),
                    _ => Ok(side * child),
                }
            }
            _ => expr.with_children(children),
        };
        Ok(rate.fold(written)?)
    }
}

/// The argument of a jump, if this is one.
fn jump_of(part: &Expr) -> Option<&Expr> {
    match part.node() {
        Node::Function(Function::Sign | Function::Step, arguments) => arguments.first(),
        _ => None,
    }
}

/// The factors c of the states with u = d/dt (c y), where u is a sum of velocities with numbers for
/// factors; `None` if it is not.
fn place_of(argument: &Expr, states: &[Symbol]) -> Result<Option<Vec<f64>>, ResponseError> {
    let mut factors = vec![0.0; states.len()];
    let mut rest = argument.expand()?;
    for (place, state) in states.iter().enumerate() {
        let velocity = state.derivative();
        if !rest.contains(velocity) || !states.contains(&velocity) {
            continue;
        }
        let factor = rest.differentiate(velocity)?.expand()?;
        let Some(number) = factor.as_number() else { return Ok(None) };
        factors[place] = to_f64(number);
        rest = rest.substitute(velocity, &Expr::zero())?.expand()?;
    }
    Ok(rest.is_zero().then_some(factors))
}

/// The linear function of a side with the values that an expression has on both sides.
fn linear_in(expression: Expr, side: Symbol) -> Result<Expr, ResponseError> {
    let is_linear = !expression.contains(side) || !expression.differentiate(side)?.contains(side);
    if is_linear {
        return Ok(expression);
    }
    let on = |value: i64| expression.substitute(side, &Expr::from(value));
    let (above, below) = (on(1)?, on(-1)?);
    let twice = &above + &below + Expr::from(side) * (&above - &below);
    Ok(Expr::divide(&twice, &Expr::from(2))?)
}

/// The term of a rate in which two jumps stand; the rate itself if no one term has both.
fn product_of(rate: &Expr, jumps: [&Expr; 2]) -> String {
    let whole = rate.expand().unwrap_or_else(|_| rate.clone());
    let has = |term: &Expr, jump: &Expr| {
        term.unique_nodes().any(|part| jump_of(part).is_some_and(|argument| argument == jump))
    };
    let term = whole.terms().iter().find(|term| jumps.iter().all(|jump| has(term, jump)));
    term.unwrap_or(&whole).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surfaces(rates: &[&str]) -> Result<Option<JumpSurfaces>, ResponseError> {
        let states: Vec<Symbol> = ["x", "y", "x'", "y'"].map(Symbol::new).into();
        let velocities = ["x'", "y'"];
        let right = velocities.iter().chain(rates).map(|text| text.parse().expect("a rate"));
        JumpSurfaces::new(&states, "t".into(), &right.collect::<Vec<Expr>>(), "v".into(), &[])
    }

    #[test]
    fn each_surface_is_found_once_and_told_whether_it_holds() {
        let found = surfaces(&[
            "-x - sgn(x' - y') - abs(x' - y')",
            "sgn(2*x' - 2*y') + H(y - 1)*sgn(x' - v)",
        ]);
        let found = found.expect("surfaces").expect("jumps");
        assert_eq!(found.arguments.len(), 3);
        let holds: Vec<(String, bool)> =
            found.arguments.iter().map(ToString::to_string).zip(found.holds).collect();
        // x' - v stands in the rate of y' alone, so that nothing stays on it.
        assert!(holds.contains(&("x' - y'".to_owned(), true)), "{holds:?}");
        assert!(holds.iter().filter(|(_, holds)| *holds).count() == 1, "{holds:?}");
        assert!(surfaces(&["-x", "-y"]).expect("none").is_none());
    }

    #[test]
    fn products_of_two_frictions_are_refused_and_powers_are_linear() {
        let refused = surfaces(&["-x - 3*sgn(x')*sgn(x' - y')", "-y + sgn(x' - y')"]);
        let ResponseError::CoupledJump(term) = refused.expect_err("a product") else { panic!() };
        assert_eq!(term, "-3*sgn(x')*sgn(x' - y')");
        let found = surfaces(&["-H(x')^2*(1 + x)", "-y"]).expect("surfaces").expect("jumps");
        // On the surface between both sides: half of the jump.
        let at = |side: f64| found.rates.at(&[0.5, 0.0, 0.0, 0.0, 0.0, 0.0, side])[(2, 0)];
        assert_eq!([at(1.0), at(0.0), at(-1.0)], [-1.5, -0.75, 0.0]);
    }
}

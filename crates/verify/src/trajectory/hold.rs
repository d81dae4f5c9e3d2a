//! Sticking by dry friction: a coordinate at rest, a block on a moving belt, two bodies that stick
//! to each other.
//!
//! ```text
//! y' = f(y, t; s_1, s_2, ...),  s_i = sgn(u_i),  u_i linear in the velocities
//! held on u_i = 0:    du_i/dt(s) = 0 for every i that is held,  |s_i| <= 1          the s are linear equations away
//! released:           |s_i| grows through 1; from there on s_i is its sign, until u_i returns to zero
//! ```
//!
//! (A. F. Filippov, *Differential Equations with Discontinuous Righthand Sides*, Kluwer 1988,
//! chapter 2; several at a time: F. Pfeiffer, C. Glocker, *Multibody Dynamics with Unilateral
//! Contacts*, Wiley 1996.) `H(u)` is `(1 + sgn(u))/2`. While u_i = 0 holds, one velocity is
//! determined by this equation and is not integrated. A coordinate of an equation of first order, such as
//! the slider of a spring in series with dry friction, counts as a velocity here.
//!
//! At the onset of a slip u_i and its rate are both zero, so that rounding decides in which
//! direction u_i leaves its zero. Therefore only crossings in one direction end a segment, and each
//! such event has a second one at a level that rounding does not reach.
//!
//! With static friction r > 1 times the sliding one, a held surface is released where |s_i| grows
//! through r (H. Olsson, K. J. Åström, C. Canudas de Wit, M. Gäfvert, P. Lischinsky, *European Journal of Control* 4
//! (1998) 176, section 2). The equations as typed do not show that a motion with 1 < |s_i| < r is held, so that each
//! zero of a u_i ends a segment.

use std::collections::BTreeMap;

use super::{
    PoincareSection, Ready, TrajectoryError, TrajectoryRequest, TrajectorySegment, surplus,
};
use crate::exact::{from_f64, ratio};
use crate::expr::{CompiledFunction, Expr, ExprError, Function, Node};
use crate::mechanics::{Rates, linear};
use crate::symbol::{Symbol, fresh_stem};
use crate::system::{Event, Integrator, Path, PathEnd, System, SystemOptions};

/// Largest speed that counts as zero up to rounding, relative to speeds and positions of order one.
const AT_REST: f64 = 1e-9;

/// Largest force that counts as zero up to rounding and the error of the steps, relative to the
/// friction.
const ROUNDING: f64 = 1e-9;

/// Largest speed that counts as zero at the onset of a slip, relative to the change of speed by
/// friction per unit of time.
const UNSEEN: f64 = 1e-12;

/// A force that exceeds the friction by this fraction starts a slip at once.
const CLEARLY: f64 = 1e-3;

/// Largest number of sticking phases.
const MOST_HOLDS: usize = 10_000;

/// Number of consecutive segments of length zero after which the motion is stuck.
pub(super) const IDLE: usize = 8;

/// A surface u = 0 on which the rates jump.
#[derive(Clone, Debug)]
struct Surface {
    u: Expr,
    /// Every argument of a `sgn`, `H` or `abs` that vanishes with u, and whether it has the sign of
    /// u.
    arguments: Vec<(Expr, bool)>,
    /// Half of the jump of du/dt.
    strength: f64,
}

/// The mode of a switching surface on a segment of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SurfaceRegime {
    /// The equations apply as typed; the surface is a corner of theirs.
    Typed,
    /// The motion stays on it.
    Held,
    /// The motion stays on it because it stays on others; its friction, relative to its bound,
    /// equals that of the surface of this number, with this sign.
    Tied(usize, i64),
    /// The motion has left it to this side, 1 or -1, and has not come back yet.
    Left(i64),
}

/// The surfaces on which a motion is at the beginning of a segment, with their modes.
type Regimes = Vec<(Surface, SurfaceRegime)>;

/// The map from the integrated states to all states.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// The index of each state among the integrated ones, or its value in terms of them.
    all_states: Vec<Result<usize, CompiledFunction>>,
    /// The values of the symbols in these.
    numbers: Vec<f64>,
}

impl Layout {
    /// All states at a time.
    pub(super) fn states(&self, time: f64, followed: &[f64]) -> Vec<f64> {
        let arguments: Vec<f64> =
            followed.iter().copied().chain([time]).chain(self.numbers.iter().copied()).collect();
        let state = |state: &Result<usize, CompiledFunction>| match state {
            Ok(place) => followed[*place],
            Err(value) => value.call(&arguments),
        };
        self.all_states.iter().map(state).collect()
    }
}

/// The end of a motion from one impact or event to the next, or to its end.
pub(super) struct StretchEnd {
    /// The reason why it ends.
    pub(super) reason: PathEnd,
    /// Whether the states at its end are known.
    pub(super) has_states: bool,
}

impl TrajectoryRequest {
    /// Adds the motion to the pieces segment by segment, each by the equations as typed or with surfaces held by
    /// friction, until a guard falls through zero or the motion ends; the state becomes that at its end. The first
    /// segment, by the equations as typed, is given if it has been followed.
    pub(super) fn follow_stretch(
        &self,
        equations: &Ready,
        first: Option<Path>,
        (from, state): (f64, &mut Vec<f64>),
        integrator: Integrator,
        pieces: &mut Vec<TrajectorySegment>,
    ) -> Result<StretchEnd, TrajectoryError> {
        let options = self.options(integrator);
        let mut regimes = Regimes::new();
        let (mut first, mut from) = (first, from);
        if equations.static_friction > 1.0 {
            let found = surfaces(equations, from, state)?;
            regimes = regimes_at(equations, found, from, state, None)?.unwrap_or_default();
        }
        let (mut idle, mut holds) = (0, 0);
        let mut has_states = false;
        let reason = loop {
            let piece = match regimes.iter().all(|(_, regime)| *regime == SurfaceRegime::Typed) {
                true => TrajectorySegment {
                    recorded: equations.recorded,
                    layout: None,
                    from,
                    path: match first.take() {
                        Some(first) => first,
                        None => equations.solver.solve([from, self.duration], state)?,
                    },
                },
                false => match self.stretch(equations, &regimes, from, state, &options)? {
                    Some(piece) => piece,
                    None => break PathEnd::Sticks,
                },
            };
            let (end, reason) = (piece.end(), piece.path.reason());
            has_states = piece.write_last_states(state);
            // The events before those of the surfaces.
            let others = piece.recorded + equations.guards.len();
            holds += usize::from(piece.is_held());
            pieces.push(piece);
            if !has_states || matches!(reason, PathEnd::Event(event) if event < others) {
                break reason;
            }
            // Other surfaces can take over only if there are more frictions than needed.
            let hit = match reason {
                PathEnd::Event(event) => hit(&regimes, event - others),
                _ => None,
            };
            let released = match reason {
                PathEnd::Event(event) => hit.is_none() && released(&mut regimes, event - others),
                PathEnd::Sticks => false,
                reason => break reason,
            };
            if !released {
                regimes = match surfaces(equations, end, state)? {
                    found if found.is_empty() => break PathEnd::Sticks,
                    found => match regimes_at(equations, found, end, state, hit.as_ref())? {
                        Some(regimes) => regimes,
                        None => break PathEnd::Sticks,
                    },
                };
            }
            idle = if end > from { 0 } else { idle + 1 };
            if idle > IDLE || holds > MOST_HOLDS {
                break PathEnd::Sticks;
            }
            from = end;
        };
        Ok(StretchEnd { reason, has_states })
    }

    /// The motion from a time on, until a held surface is released or one that was left is reached
    /// again. The held states are set to their fixed values. `None` if the equations of this mode
    /// cannot be formed.
    fn stretch(
        &self,
        equations: &Ready,
        regimes: &Regimes,
        from: f64,
        state: &mut [f64],
        options: &SystemOptions,
    ) -> Result<Option<TrajectorySegment>, TrajectoryError> {
        let Some(sliding) = sliding(equations, regimes, &numbers_at(equations, from, state))?
        else {
            return Ok(None);
        };
        let followed: Vec<usize> = (0..state.len())
            .filter(|index| !sliding.fixed.contains_key(&equations.states[*index]))
            .collect();
        let names: Vec<Symbol> = followed.iter().map(|index| equations.states[*index]).collect();
        let right: Vec<Expr> = followed.iter().map(|index| sliding.right[*index].clone()).collect();
        let arguments: Vec<Symbol> = names
            .iter()
            .chain([&Symbol::new("t")])
            .chain(equations.values.keys())
            .copied()
            .collect();
        let of_state = |(index, name): (usize, &Symbol)| match sliding.fixed.get(name) {
            None => Ok(Ok(followed.partition_point(|place| *place < index))),
            Some(value) => CompiledFunction::new(value, &arguments).map(Err),
        };
        let states: Result<Vec<_>, _> = equations.states.iter().enumerate().map(of_state).collect();
        let Ok(states) = states else { return Ok(None) };
        let layout =
            Layout { all_states: states, numbers: equations.values.values().copied().collect() };
        let start: Vec<f64> = followed.iter().map(|index| state[*index]).collect();
        state.copy_from_slice(&layout.states(from, &start));
        let rates = Rates { states: names.clone(), right: right.clone() };
        let section = self
            .section
            .as_ref()
            .map(|section| section.with_fixed_states(&sliding.fixed))
            .transpose()?;
        let mut events = section.map_or(vec![], |section| section.events(&rates));
        let recorded = events.len();
        for guard in &equations.guards {
            events.push(Event::stop(guard.substitute_all(&sliding.fixed)?).falling());
        }
        events.extend(sliding.events);
        for u in &equations.frictions {
            let is_known = |(surface, _): &(Surface, SurfaceRegime)| {
                surface.arguments.iter().any(|(argument, _)| argument == u)
            };
            if !regimes.iter().any(is_known) {
                events.push(Event::stop(u.substitute_all(&sliding.fixed)?));
            }
        }
        let Ok(system) = System::new(&names, Symbol::new("t"), &right, &equations.values) else {
            return Ok(None);
        };
        let system = system.with_critical_times(&equations.critical);
        let path = system.solve([from, self.duration], &start, &events, options);
        Ok(path.ok().map(|path| TrajectorySegment {
            recorded,
            layout: sliding.held.then(|| Box::new(layout)),
            from,
            path,
        }))
    }
}

impl PoincareSection {
    /// This section with these expressions in place of some states.
    fn with_fixed_states(&self, fixed: &BTreeMap<Symbol, Expr>) -> Result<Self, ExprError> {
        Ok(match self {
            Self::Every(_) | Self::Impacts | Self::Events => self.clone(),
            Self::Rising(expression) => Self::Rising(expression.substitute_all(fixed)?),
        })
    }
}

/// Number of events of each surface of a segment.
const EVENTS: usize = 4;

/// Releases the surface that an event belongs to; `false` if the event is the return to a surface.
fn released(regimes: &mut Regimes, event: usize) -> bool {
    match regimes.get_mut(event / EVENTS) {
        Some((_, regime)) if *regime == SurfaceRegime::Held => {
            *regime = SurfaceRegime::Left(if event.is_multiple_of(2) { 1 } else { -1 });
            true
        }
        _ => false,
    }
}

/// The surface whose friction reaches its bound in an event, if some frictions are tied to each
/// other; `None` otherwise.
fn hit(regimes: &Regimes, event: usize) -> Option<Expr> {
    let surplus = regimes.iter().any(|(_, regime)| matches!(regime, SurfaceRegime::Tied(..)));
    let (surface, _) = regimes
        .get(event / EVENTS)
        .filter(|(_, regime)| surplus && *regime == SurfaceRegime::Held)?;
    Some(surface.u.clone())
}

/// The values of all symbols.
fn numbers_at(equations: &Ready, time: f64, state: &[f64]) -> BTreeMap<Symbol, f64> {
    let mut numbers = equations.values.clone();
    numbers.insert(Symbol::new("t"), time);
    numbers.extend(equations.states.iter().copied().zip(state.iter().copied()));
    numbers
}

/// The states of which a jump of the rates can hold one: the velocities, whose name is that of another
/// state with a prime, and the coordinates of equations of first order, which have no velocity.
fn velocities(equations: &Ready) -> impl Iterator<Item = Symbol> {
    let states = &equations.states;
    let is_position = move |name: &&Symbol| states.contains(&name.derivative());
    states.iter().filter(move |name| !is_position(name)).copied()
}

/// The arguments of `sgn` and `H` in rates that are linear in the velocities: where one is zero, static friction
/// may hold.
pub(super) fn friction_arguments(states: &[Symbol], right: &[Expr]) -> Vec<Expr> {
    let is_position = |name: &&Symbol| states.contains(&name.derivative());
    let velocities: Vec<Symbol> =
        states.iter().filter(|name| !is_position(name)).copied().collect();
    let is_linear = |argument: &Expr| {
        let mut slopes = velocities.iter().map(|velocity| argument.differentiate(*velocity));
        velocities.iter().any(|velocity| argument.contains(*velocity))
            && slopes.all(|slope| {
                slope.is_ok_and(|slope| velocities.iter().all(|name| !slope.contains(*name)))
            })
    };
    let jumps = |part: &Expr| match part.node() {
        Node::Function(Function::Sign | Function::Step, arguments) => arguments.first().cloned(),
        _ => None,
    };
    let mut found: Vec<Expr> = Vec::new();
    for argument in right.iter().flat_map(|right| right.unique_nodes().filter_map(jumps)) {
        if !found.contains(&argument) && is_linear(&argument) {
            found.push(argument);
        }
    }
    found
}

/// A velocity that an expression is linear in, the one that it depends on most here, and its
/// coefficient; `None` if the expression is not linear in the velocities, or contains none.
fn leading_velocity(
    expression: &Expr,
    equations: &Ready,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<(Symbol, Expr)> {
    let mut leading: Option<(f64, Symbol, Expr)> = None;
    for velocity in velocities(equations).filter(|velocity| expression.contains(*velocity)) {
        let coefficient = expression.differentiate(velocity).ok()?;
        if velocities(equations).any(|velocity| coefficient.contains(velocity)) {
            return None;
        }
        let size = coefficient.evaluate(numbers).ok()?.abs();
        if size > 0.0 && leading.as_ref().is_none_or(|(largest, ..)| size > *largest) {
            leading = Some((size, velocity, coefficient));
        }
    }
    leading.map(|(_, velocity, coefficient)| (velocity, coefficient))
}

/// Solves u = 0 for its leading velocity.
fn solved(
    u: &Expr,
    equations: &Ready,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Option<(Symbol, Expr)>, ExprError> {
    let Some((velocity, coefficient)) = leading_velocity(u, equations, numbers) else {
        return Ok(None);
    };
    let rest = u.substitute(velocity, &Expr::zero())?;
    Ok(Some((velocity, -Expr::divide(&rest, &coefficient)?)))
}

/// The surfaces on which a state lies, up to rounding, and across which the rates jump.
fn surfaces(equations: &Ready, time: f64, state: &[f64]) -> Result<Vec<Surface>, ExprError> {
    let numbers = numbers_at(equations, time, state);
    let size = 1.0 + state.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let corner = |part: &Expr| match part.node() {
        Node::Function(
            function @ (Function::Sign | Function::Step | Function::Absolute),
            arguments,
        ) => Some((*function != Function::Absolute, arguments.first()?.clone())),
        _ => None,
    };
    let mut corners: Vec<(bool, Expr)> = Vec::new();
    for found in equations.right.iter().flat_map(|right| right.unique_nodes().filter_map(corner)) {
        if !corners.contains(&found) {
            corners.push(found);
        }
    }
    // Corners that jump come first, because they define the surfaces.
    corners.sort_by_key(|(jumps, _)| !jumps);
    let mut found: Vec<Surface> = Vec::new();
    for (jumps, argument) in corners {
        let Some((velocity, coefficient)) = leading_velocity(&argument, equations, &numbers) else {
            continue;
        };
        let (Ok(value), Ok(slope)) = (argument.evaluate(&numbers), coefficient.evaluate(&numbers))
        else {
            continue;
        };
        if value.is_nan() || value.abs() > AT_REST * size * slope.abs() {
            continue;
        }
        let known = found.iter_mut().find_map(|surface| {
            let ratio = argument.differentiate(velocity).ok()?.evaluate(&numbers).ok()?
                / surface.u.differentiate(velocity).ok()?.evaluate(&numbers).ok()?;
            let factor = Expr::number(from_f64(ratio)?);
            let apart = (&argument - &(&factor * &surface.u)).expand().ok()?;
            let states = equations
                .states
                .iter()
                .chain([&Symbol::new("t")])
                .any(|state| apart.contains(*state));
            let same = !states && apart.evaluate(&numbers).ok()?.abs() <= AT_REST * slope.abs();
            same.then_some((surface, ratio > 0.0))
        });
        match known {
            Some((surface, sign)) => surface.arguments.push((argument, sign)),
            None if jumps => found.push(Surface {
                u: argument.clone(),
                arguments: vec![(argument, true)],
                strength: 0.0,
            }),
            None => {}
        }
    }
    Ok(found)
}

/// Determines the mode of each of these surfaces, on all of which a state lies: held if the
/// required friction is within its bound. On the surface that was just hit the friction is at its
/// bound, unless others take over. Returns `None` if the modes cannot be determined.
fn regimes_at(
    equations: &Ready,
    found: Vec<Surface>,
    time: f64,
    state: &[f64],
    hit: Option<&Expr>,
) -> Result<Option<Regimes>, ExprError> {
    let mut numbers = numbers_at(equations, time, state);
    let mut regimes = Regimes::new();
    for mut surface in found {
        let alone = vec![(surface.clone(), SurfaceRegime::Held)];
        let jump = sliding(equations, &alone, &numbers)?
            .and_then(|own| own.jumps.first()?.evaluate(&numbers).ok());
        // A surface does not hold if the rates lead away on both sides or do not jump.
        if let Some(jump) = jump.filter(|jump| *jump < 0.0) {
            surface.strength = -jump;
            regimes.push((surface, SurfaceRegime::Held));
        }
    }
    let most = equations.static_friction;
    let mut excess = f64::INFINITY;
    loop {
        if !tie_frictions(equations, &mut regimes, &numbers)? {
            return Ok(None);
        }
        let Some(sliding) = sliding(equations, &regimes, &numbers)? else {
            return Ok(None);
        };
        for (name, value) in &sliding.fixed {
            let Ok(value) = value.evaluate(&numbers) else {
                return Ok(None);
            };
            numbers.insert(*name, value);
        }
        let mut worst: Option<(usize, f64)> = None;
        for (index, share) in &sliding.shares {
            let Ok(share) = share.evaluate(&numbers) else {
                return Ok(None);
            };
            if share.is_nan() {
                return Ok(None);
            }
            let is_hit = regimes.iter().enumerate().any(|(other, (surface, regime))| {
                let of_one_size = other == *index
                    || matches!(regime, SurfaceRegime::Tied(lead, _) if lead == index);
                of_one_size && hit == Some(&surface.u)
            });
            let bound = most * if is_hit { 1.0 - ROUNDING } else { 1.0 + ROUNDING };
            if share.abs() > bound && worst.is_none_or(|(_, largest)| share.abs() > largest.abs()) {
                worst = Some((*index, share));
            }
        }
        if let Some((index, share)) = worst {
            let side = if share > 0.0 { 1 } else { -1 };
            for (other, (_, regime)) in regimes.iter_mut().enumerate() {
                *regime = match *regime {
                    SurfaceRegime::Tied(lead, sign) if lead == index => {
                        SurfaceRegime::Left(sign * side)
                    }
                    _ if other == index => SurfaceRegime::Left(side),
                    regime => regime,
                };
            }
            excess = excess.min(share.abs() / most - 1.0);
            continue;
        }
        if sliding.shares.is_empty() && excess > CLEARLY && most == 1.0 {
            // The equations as typed determine the motion at a corner.
            regimes.iter_mut().for_each(|(_, regime)| *regime = SurfaceRegime::Typed);
        }
        return Ok(Some(regimes));
    }
}

/// Gives equal shares to the frictions that the equations leave undetermined, because more of them
/// are at rest than there are independent velocities. `false` if that is not possible.
fn tie_frictions(
    equations: &Ready,
    regimes: &mut Regimes,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<bool, ExprError> {
    for (_, regime) in regimes.iter_mut() {
        if matches!(regime, SurfaceRegime::Tied(..)) {
            *regime = SurfaceRegime::Held;
        }
    }
    let Some(rates) = SurfaceRates::new(equations, regimes, numbers)? else {
        return Ok(false);
    };
    if rates.independent.len() == rates.on.len() {
        return Ok(true);
    }
    let mut numbers = numbers.clone();
    for (name, value) in &rates.fixed {
        let Ok(value) = value.evaluate(&numbers) else {
            return Ok(false);
        };
        numbers.insert(*name, value);
    }
    let none: BTreeMap<Symbol, Expr> =
        rates.on.iter().map(|index| (rates.share(*index), Expr::zero())).collect();
    let (mut matrix, mut right) = (Vec::new(), Vec::new());
    for index in &rates.on {
        let rate = rates.rate_of(equations, &regimes[*index].0.u)?;
        let mut row = Vec::new();
        for column in &rates.on {
            let entry = rate.differentiate(rates.share(*column))?.substitute_all(&none)?;
            let Ok(entry) = entry.evaluate(&numbers) else {
                return Ok(false);
            };
            row.push(entry);
        }
        let Ok(free) = rate.substitute_all(&none)?.evaluate(&numbers) else {
            return Ok(false);
        };
        matrix.push(row);
        right.push(-free);
    }
    let Some(groups) = surplus::of_one_size(&matrix, &right) else {
        return Ok(false);
    };
    for group in groups {
        let Some(((lead, first), others)) = group.split_first() else {
            continue;
        };
        for (other, sign) in others {
            let regime = &mut regimes[rates.on[*other]].1;
            if *regime != SurfaceRegime::Held {
                return Ok(false);
            }
            *regime = SurfaceRegime::Tied(rates.on[*lead], sign * first);
        }
    }
    Ok(true)
}

/// The rates of all states, with a symbol for each friction that holds.
struct SurfaceRates {
    /// The rates of all states.
    right: Vec<Expr>,
    /// The velocities that are held, in terms of the other states.
    fixed: BTreeMap<Symbol, Expr>,
    /// The surfaces that the motion stays on.
    on: Vec<usize>,
    /// The surfaces whose frictions are linearly independent.
    independent: Vec<usize>,
    /// The common stem of the names.
    stem: String,
}

impl SurfaceRates {
    fn new(
        equations: &Ready,
        regimes: &Regimes,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<Option<Self>, ExprError> {
        let taken: Vec<Symbol> =
            equations.states.iter().chain(equations.values.keys()).copied().collect();
        let on: Vec<usize> = (0..regimes.len())
            .filter(|index| {
                matches!(regimes[*index].1, SurfaceRegime::Held | SurfaceRegime::Tied(..))
            })
            .collect();
        let mut rates = Self {
            right: Vec::new(),
            fixed: BTreeMap::new(),
            on,
            independent: Vec::new(),
            stem: fresh_stem("share", &taken),
        };
        // Each held velocity is expressed by the remaining states.
        for index in rates.on.clone() {
            let typed = &regimes[index].0.u;
            let u = typed.substitute_all(&rates.fixed)?.expand()?;
            let slope_of = |u: &Expr| -> Option<f64> {
                let (_, coefficient) = leading_velocity(u, equations, numbers)?;
                Some(coefficient.evaluate(numbers).ok()?.abs())
            };
            let Some(slope) = slope_of(typed) else {
                return Ok(None);
            };
            // It is held already by the surfaces before.
            if velocities(equations).all(|velocity| !u.contains(velocity))
                || slope_of(&u).is_some_and(|left| left <= AT_REST * slope)
            {
                continue;
            }
            let Some((velocity, value)) = solved(&u, equations, numbers)? else {
                return Ok(None);
            };
            for other in rates.fixed.values_mut() {
                *other = other.substitute(velocity, &value)?;
            }
            rates.fixed.insert(velocity, value);
            rates.independent.push(index);
        }
        let replaced = |expression: &Expr| -> Result<Expr, ExprError> {
            expression
                .fold(|expr, children: &[Expr]| {
                    on_surfaces(expr, children, regimes, &|index| rates.share(index))
                })?
                .substitute_all(&rates.fixed)
        };
        let right = equations.right.iter().map(replaced).collect::<Result<_, _>>()?;
        Ok(Some(Self { right, ..rates }))
    }

    /// The symbol of a friction relative to its bound.
    fn share(&self, index: usize) -> Symbol {
        Symbol::new(&format!("{}{index}", self.stem))
    }

    /// The rate of an expression.
    fn rate_of(&self, equations: &Ready, u: &Expr) -> Result<Expr, ExprError> {
        let mut parts = vec![u.differentiate(Symbol::new("t"))?];
        for (state, rate) in equations.states.iter().zip(&self.right) {
            parts.push(u.differentiate(*state)? * rate);
        }
        Expr::sum(parts).substitute_all(&self.fixed)
    }
}

/// The equations of a segment on which surfaces are held or have been left.
struct Sliding {
    /// The rates of all states.
    right: Vec<Expr>,
    /// The velocities that are held, in terms of the other states.
    fixed: BTreeMap<Symbol, Expr>,
    /// The friction that each surface needs, relative to its bound, by the number of the surface.
    shares: Vec<(usize, Expr)>,
    /// Half of the jump of du/dt across each of these surfaces.
    jumps: Vec<Expr>,
    /// The events that end the segment: [`EVENTS`] for each surface.
    events: Vec<Event>,
    /// Whether anything is held.
    held: bool,
}

fn sliding(
    equations: &Ready,
    regimes: &Regimes,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Option<Sliding>, ExprError> {
    let Some(rates) = SurfaceRates::new(equations, regimes, numbers)? else {
        return Ok(None);
    };
    let held: Vec<usize> =
        (0..regimes.len()).filter(|index| regimes[*index].1 == SurfaceRegime::Held).collect();
    if held.len() != rates.independent.len() {
        return Ok(None);
    }
    let share = |index: usize| rates.share(index);
    let (right, fixed) = (&rates.right, &rates.fixed);
    let mut matrix = Vec::new();
    let mut rest = Vec::new();
    let none: BTreeMap<Symbol, Expr> =
        held.iter().map(|index| (share(*index), Expr::zero())).collect();
    for index in &rates.independent {
        let rate = rates.rate_of(equations, &regimes[*index].0.u)?;
        let row: Vec<Expr> = held
            .iter()
            .map(|column| rate.differentiate(share(*column)))
            .collect::<Result<_, _>>()?;
        // Only frictions that enter linearly can be solved for.
        if row.iter().any(|entry| held.iter().any(|column| entry.contains(share(*column)))) {
            return Ok(None);
        }
        matrix.push(row);
        rest.push(-rate.substitute_all(&none)?);
    }
    let jumps: Vec<Expr> = (0..held.len()).map(|row| matrix[row][row].clone()).collect();
    // Among tied frictions one may act on another surface than its own.
    if held == rates.independent && jumps.iter().any(Expr::is_zero) {
        return Ok(None);
    }
    let singular = || crate::mechanics::MechanicsError::Singular(Expr::zero());
    let Ok(found) = linear::solution(&matrix, &rest, &[], singular) else {
        return Ok(None);
    };
    let shares: Vec<(usize, Expr)> = held.iter().copied().zip(found).collect();
    let values: BTreeMap<Symbol, Expr> =
        shares.iter().map(|(index, value)| (share(*index), value.clone())).collect();
    let right = right.iter().map(|rate| rate.substitute_all(&values)).collect::<Result<_, _>>()?;
    let mut events = Vec::new();
    for (index, (surface, regime)) in regimes.iter().enumerate() {
        events.extend(match regime {
            SurfaceRegime::Typed | SurfaceRegime::Tied(..) => {
                [(); EVENTS].map(|()| Event::record(Expr::from(1)))
            }
            SurfaceRegime::Held => {
                let share = values.get(&share(index)).cloned().unwrap_or_else(Expr::zero);
                let most = equations.static_friction;
                let [one, more] = [most, most * (1.0 + 2.0 * ROUNDING)].map(number);
                [
                    Event::stop(&share - &one).rising(),
                    Event::stop(&share + &one).falling(),
                    Event::stop(&share - &more).rising(),
                    Event::stop(&share + &more).falling(),
                ]
            }
            SurfaceRegime::Left(side) => {
                let away = Expr::from(*side) * surface.u.substitute_all(fixed)?;
                let unseen = number(UNSEEN * surface.strength);
                [
                    Event::stop(away.clone()).falling(),
                    Event::stop(away + unseen).falling(),
                    Event::record(Expr::from(1)),
                    Event::record(Expr::from(1)),
                ]
            }
        });
    }
    Ok(Some(Sliding { right, held: !held.is_empty(), fixed: rates.fixed, shares, jumps, events }))
}

/// A finite number as an expression.
fn number(value: f64) -> Expr {
    from_f64(value).map_or_else(Expr::zero, Expr::number)
}

/// A rate on these surfaces: `sgn`, `H` and `abs` of arguments that are zero there, or that have
/// been left to one side, are replaced.
fn on_surfaces(
    expr: &Expr,
    children: &[Expr],
    regimes: &Regimes,
    share: &dyn Fn(usize) -> Symbol,
) -> Result<Expr, ExprError> {
    let Node::Function(
        function @ (Function::Sign | Function::Step | Function::Absolute),
        arguments,
    ) = expr.node()
    else {
        return expr.with_children(children);
    };
    let meant = regimes.iter().enumerate().find_map(|(index, (surface, regime))| {
        let known = surface.arguments.iter().find(|(known, _)| arguments.first() == Some(known));
        known.map(|(_, same)| (index, *regime, if *same { 1 } else { -1 }))
    });
    let sign = match meant {
        None | Some((_, SurfaceRegime::Typed, _)) => return expr.with_children(children),
        Some((index, SurfaceRegime::Held, same)) => Expr::from(same) * Expr::from(share(index)),
        Some((_, SurfaceRegime::Tied(lead, sign), same)) => {
            Expr::from(same * sign) * Expr::from(share(lead))
        }
        Some((_, SurfaceRegime::Left(side), same)) => Expr::from(same * side),
    };
    Ok(match (function, meant, arguments.first()) {
        (Function::Sign, ..) => sign,
        (Function::Step, ..) => (Expr::from(1) + sign) * Expr::number(ratio(1, 2)),
        (_, Some((_, SurfaceRegime::Left(_), _)), Some(argument)) => sign * argument,
        _ => Expr::zero(),
    })
}

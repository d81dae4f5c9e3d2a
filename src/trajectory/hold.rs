//! Where dry friction holds the only coordinate that there is: at rest, or on a belt that runs.
//!
//! ```text
//! x'' = a(x, v, t; s),   s = sgn(v - c):    held while  a(s = 1) <= 0 <= a(s = -1),    x = x_0 + c (t - t_0)
//! the friction that holds:  a(s) = 0,   s = (a+ + a-)/(a- - a+),   -1 < s < 1
//! ```
//!
//! (A. F. Filippov, *Differential Equations with Discontinuous Righthand Sides*, Kluwer 1988, chapter 2.) Corners of the force with the
//! velocity alone, `sgn(x' - c)` and `H(x' - c)`, can hold it; elsewhere a motion that stays on its corner is not followed.

use std::collections::BTreeMap;

use super::{Course, TrajectoryError};
use crate::exact::from_f64;
use crate::expr::{Expr, ExprError, Function, Node};
use crate::symbol::{Symbol, fresh};
use crate::system::{End, Event, Options, Path, System};

/// A stretch of a motion that friction holds.
#[derive(Clone, Debug)]
pub(super) struct Hold {
    /// Coordinate, velocity and works where it begins.
    state: Vec<f64>,
    pub(super) from: f64,
    pub(super) until: f64,
    /// Position and works on a belt that runs; nothing at rest.
    path: Option<Path>,
}

/// How much longer a hold lasts than it must, over the duration: at its very end nothing pulls yet, and it would be held again. The motion
/// grows with the cube of the time, so that a delay d leaves an error of d^2.
const DELAY: f64 = 1e-9;

/// A speed that rounding leaves of the one that holds.
const AT_REST: f64 = 1e-9;

/// What rounding and the steps leave of a pull, in parts of the jump of the friction.
const ROUNDING: f64 = 1e-9;

impl Hold {
    /// Coordinate, velocity and works at a time.
    pub(super) fn at(&self, time: f64) -> Vec<f64> {
        let mut state = self.state.clone();
        let Some(path) = &self.path else { return state };
        // Behind the last force that holds it is carried on for next to no time.
        let late = (time - path.end()).max(0.0);
        let (last, before) = (path.at(time - late), path.at(time - 2.0 * late));
        let carried = match (last, before) {
            (Some(last), Some(before)) if late > 0.0 => last
                .iter()
                .zip(&before)
                .map(|(last, before)| 2.0 * last - before)
                .collect(),
            (Some(last), _) => last,
            (None, _) => return state,
        };
        if let Some((position, works)) = carried.split_first() {
            state[0] = *position;
            state[2..].copy_from_slice(works);
        }
        state
    }
}

/// A jump of the accelerations with the velocity.
struct Jump {
    /// The velocity at which it is.
    speed: f64,
    /// As they are above and below, at that velocity.
    sides: [Vec<Expr>; 2],
}

impl Course {
    /// How dry friction holds the only coordinate that there is, from a time on, and until when: until the acceleration on one side of
    /// the jump leads away from it. Nothing where it is not held. `right` are the rates of the states and of the works.
    pub(super) fn held(
        &self,
        from: f64,
        state: &[f64],
        (right, values): (&[Expr], &BTreeMap<Symbol, f64>),
        critical: &[f64],
        options: &Options,
    ) -> Result<Option<Hold>, TrajectoryError> {
        let ([place, velocity], [x, speed, ..]) = (self.rates.states.as_slice(), state) else {
            return Ok(None);
        };
        let Some(jump) = jump_at(right, [*place, *velocity], (*x, *speed), values)? else {
            return Ok(None);
        };
        let [forward, backward] = jump.sides.each_ref().map(|side| &side[1]);
        let mut numbers = values.clone();
        numbers.insert(*velocity, jump.speed);
        let at = |expression: &Expr| {
            let mut numbers = numbers.clone();
            numbers.extend([(*place, *x), (Symbol::new("t"), from)]);
            expression.evaluate(&numbers)
        };
        let (Ok(above), Ok(below)) = (at(forward), at(backward)) else {
            return Ok(None);
        };
        // At rest nothing changes any more where time does not occur: what rounding leaves at the edge of the held places is no pull.
        let at_edge = jump.speed == 0.0 && ![forward, backward].iter().any(|side| side.contains(Symbol::new("t")));
        let slack = if at_edge { ROUNDING * (below - above).abs() } else { 0.0 };
        if !(above <= slack && below >= -slack) {
            return Ok(None);
        }
        let mut hold = Hold {
            state: state.to_vec(),
            from,
            until: from,
            path: None,
        };
        hold.state[1] = jump.speed;
        if from >= self.duration {
            return Ok(Some(hold));
        }
        let events = [Event::stop(forward.clone()), Event::stop(backward.clone())];
        let carried = jump.speed != 0.0;
        let (states, rates, start) = match carried {
            // Power is needed where it moves only.
            true => {
                let works: Vec<Symbol> = works(&numbers, state.len() - 2);
                let states: Vec<Symbol> = [*place].into_iter().chain(works).collect();
                let start: Vec<f64> = [*x].into_iter().chain(state[2..].iter().copied()).collect();
                (states, carried_rates(&jump)?, start)
            }
            false => {
                numbers.insert(*place, *x);
                let nothing = fresh("nothing", &numbers.keys().copied().collect::<Vec<_>>());
                (vec![nothing], vec![Expr::zero()], vec![0.0])
            }
        };
        let clock = System::new(&states, Symbol::new("t"), &rates, &numbers)?.with_critical_times(critical);
        let path = clock.solve(from, &start, self.duration, &events, options)?;
        if !matches!(path.reason(), End::Reached | End::Event(_)) {
            return Ok(None);
        }
        hold.until = (path.end() + DELAY * self.duration).min(self.duration);
        hold.path = carried.then_some(path);
        Ok(Some(hold))
    }
}

fn works(numbers: &BTreeMap<Symbol, f64>, count: usize) -> Vec<Symbol> {
    let mut taken: Vec<Symbol> = numbers.keys().copied().collect();
    (0..count)
        .map(|_| {
            let work = fresh("work", &taken);
            taken.push(work);
            work
        })
        .collect()
}

/// The rates of position and works while friction holds: each as it is on either side, by the share at which the acceleration is zero.
fn carried_rates(jump: &Jump) -> Result<Vec<Expr>, ExprError> {
    let [above, below] = &jump.sides;
    let share = Expr::divide(&below[1], &(&below[1] - &above[1]))?;
    let mixed = |(one, other): (&Expr, &Expr)| other + &(&share * &(one - other));
    let works = above.iter().zip(below).skip(2).map(mixed);
    Ok([above[0].clone()].into_iter().chain(works).collect())
}

/// The jump of the rates with the velocity where this one is, if there is one.
fn jump_at(
    right: &[Expr],
    [place, velocity]: [Symbol; 2],
    (x, speed): (f64, f64),
    values: &BTreeMap<Symbol, f64>,
) -> Result<Option<Jump>, ExprError> {
    let own = [place, Symbol::new("t")];
    // The velocity at which an argument is zero, and whether it grows with the velocity.
    let own_speed = |argument: &Expr| -> Option<(f64, bool)> {
        let factor = argument.differentiate(velocity).ok()?;
        let rest = argument.substitute(velocity, &Expr::zero()).ok()?;
        let steady = |expr: &Expr| !own.iter().chain([&velocity]).any(|name| expr.contains(*name));
        if !steady(&factor) || !steady(&rest) {
            return None;
        }
        let (factor, rest) = (factor.evaluate(values).ok()?, rest.evaluate(values).ok()?);
        let zero = if rest == 0.0 { 0.0 } else { -rest / factor };
        (factor != 0.0 && zero.is_finite()).then_some((zero, factor > 0.0))
    };
    let near = |zero: f64| (zero - speed).abs() <= AT_REST * (1.0 + x.abs() + zero.abs());
    let argument_of = |part: &Expr| match part.node() {
        Node::Function(Function::Sign | Function::Step, arguments) => arguments.first().cloned(),
        _ => None,
    };
    let arguments = right[1].unique_nodes().filter_map(argument_of);
    let mut speeds = arguments.filter_map(|argument| own_speed(&argument));
    let Some((zero, _)) = speeds.find(|(zero, _)| near(*zero)) else {
        return Ok(None);
    };
    let Some(number) = from_f64(zero).map(Expr::number) else {
        return Ok(None);
    };
    let on_side = |expression: &Expr, side: i64| -> Result<Expr, ExprError> {
        let chosen = expression.fold(|expr, children: &[Expr]| match expr.node() {
            Node::Function(function @ (Function::Sign | Function::Step), arguments) => {
                match arguments.first().and_then(own_speed).filter(|(zero, _)| near(*zero)) {
                    Some((_, grows)) => Expr::function(*function, vec![Expr::from(if grows { side } else { -side })]),
                    None => expr.with_children(children),
                }
            }
            _ => expr.with_children(children),
        })?;
        chosen.substitute(velocity, &number)
    };
    let side = |side: i64| {
        right
            .iter()
            .map(|right| on_side(right, side))
            .collect::<Result<Vec<Expr>, _>>()
    };
    Ok(Some(Jump {
        speed: zero,
        sides: [side(1)?, side(-1)?],
    }))
}

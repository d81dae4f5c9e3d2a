//! The motion of a law and its derivatives by the parameters and by the start, integrated together.
//!
//! ```text
//! x' = v,  v' = a(x, v, t; p)       z = dx/dp, u = dv/dp:  z' = u,  u' = a_x z + a_v u + a_p
//! at v = 0, where the force of friction reverses:  u+ = u- a+/a-      (x and z are continuous)
//! ```
//!
//! The jump of `u` follows from the instant `t*` of the reversal: `v(t*; p) = 0` gives `dt*/dp = -u-/a-`, and
//! after it `v = a+ (t - t*)`. If the accelerations on both sides lead back, the motion sticks. The steps
//! are Taylor steps over many samples, one run for each half swing where the law depends on the sign of `v`.
//!
//! Powers with an unknown exponent are rounded near zero, by a share of the largest value of each half swing: the module `powers`.

use std::collections::BTreeMap;

use crate::expr::{CompiledList, Expr, ExprError, Function, Node};
use crate::fit::laws::{Law, LawError};
use crate::fit::powers::{Base, PowerTerm, by_parameter, by_variable, replace_powers, written_out};
use crate::symbol::{Symbol, fresh, fresh_stem};
use crate::system::{Event, PathEnd, Solver, System, SystemOptions};

/// The relative error of a step, far below the noise of any record; with rounded powers, whose series are long, the second number.
const TOLERANCES: [f64; 2] = [1e-10, 1e-8];

/// The largest number of half swings of a motion.
const MOST_HALF_SWINGS: usize = 100_000;

/// A value that no parameter has by chance, for preparing the recurrences: some numbers, such as 1, are
/// left out of them.
const GENERIC: f64 = 0.718_281_828;

/// A law prepared for integration with its derivatives.
#[derive(Clone, Debug)]
pub struct MotionSolver {
    names: Vec<Symbol>,
    /// For `x' > 0` and `x' < 0`; one entry if the law does not depend on the sign.
    sides: Vec<Side>,
    /// The powers with unknown exponents.
    powers: Vec<PowerTerm>,
    is_driven: bool,
}

/// A law for one sign of the velocity.
#[derive(Clone, Debug)]
struct Side {
    solver: Solver,
    /// The system that it solves, for other places of its corners.
    equations: (Vec<Symbol>, Vec<Expr>),
    events: Vec<Event>,
    options: SystemOptions,
    /// The acceleration and its derivatives by x, v and the parameters, as functions of x, v, t, the
    /// parameters and the coefficients of powers.
    acceleration: CompiledList,
}

/// The observed quantity of a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quantity {
    /// The coordinate: a displacement or an angle.
    #[default]
    Displacement,
    /// Its velocity.
    Velocity,
    /// Its acceleration.
    Acceleration,
}

/// The columns of a sampled motion.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Columns {
    /// One quantity with its derivatives.
    Of(Quantity),
    /// The coordinate with its derivatives, then the velocity with its own.
    OfPhase,
}

/// A motion at the times of a record.
#[derive(Clone, Debug, Default)]
pub struct SampledMotion {
    /// The observed quantity, then its derivatives by each parameter, by the initial coordinate and by the
    /// initial velocity: one column each.
    pub columns: Vec<Vec<f64>>,
    /// The time at which the motion comes to rest for good, held by friction.
    pub rest: Option<f64>,
}

impl MotionSolver {
    /// Prepares a law.
    ///
    /// # Errors
    /// [`LawError::Jump`] if the force jumps elsewhere than at `x' = 0`, or has no derivative.
    pub fn new(law: &Law) -> Result<Self, LawError> {
        let velocity = law.coordinate.derivative();
        let time = Symbol::new("t");
        let mut taken: Vec<Symbol> = law.acceleration.symbols().into_iter().collect();
        taken.extend([law.coordinate, velocity, time]);
        taken.extend(&law.parameters);
        let jump = |_: ExprError| LawError::Jump(law.equation.clone());
        let bases = [(velocity, Base::Velocity), (law.coordinate, Base::Coordinate)];
        let (smooth, powers) =
            replace_powers(&law.acceleration, bases, &law.parameters, &taken).map_err(jump)?;
        let [upward, downward] = [1, -1].map(|sign| on_side(&smooth, velocity, sign));
        let (upward, downward) = (upward.map_err(jump)?, downward.map_err(jump)?);
        let jumps = |expr: &Expr| {
            expr.contains_function(Function::Sign) || expr.contains_function(Function::Step)
        };
        if jumps(&upward) {
            return Err(LawError::Jump(law.equation.clone()));
        }
        // With rounded powers, which follow the amplitude, the run is cut at each half swing too.
        let is_cut = upward != downward || !powers.is_empty();
        let mut sides = vec![(upward, is_cut.then_some(true))];
        if is_cut {
            sides.push((downward, Some(false)));
        }
        let sides = sides
            .iter()
            .map(|(acceleration, stops)| Side::new(law, acceleration, (&taken, &powers), *stops));
        Ok(Self {
            names: law.parameters.clone(),
            sides: sides.collect::<Result<_, ExprError>>().map_err(jump)?,
            powers,
            is_driven: law.is_driven(),
        })
    }

    /// Integrates from the first of these increasing times, with these parameters, initial coordinate and
    /// velocity; `half_period` is the usual duration of a half swing. Returns `None` if the motion cannot be followed
    /// to the last time.
    pub fn sample(
        &self,
        parameters: &[f64],
        start: [f64; 2],
        times: &[f64],
        half_period: f64,
        quantity: Quantity,
    ) -> Option<SampledMotion> {
        self.follow(parameters, start, times, half_period, Columns::Of(quantity))
    }

    /// Coordinate and velocity at the same times, each with its derivatives, as of [`Self::sample`].
    pub(crate) fn sample_phase(
        &self,
        parameters: &[f64],
        start: [f64; 2],
        times: &[f64],
        half_period: f64,
    ) -> Option<[Vec<Vec<f64>>; 2]> {
        let motion = self.follow(parameters, start, times, half_period, Columns::OfPhase)?;
        let mut coordinates = motion.columns;
        let velocities = coordinates.split_off(coordinates.len() / 2);
        Some([coordinates, velocities])
    }

    fn follow(
        &self,
        parameters: &[f64],
        start: [f64; 2],
        times: &[f64],
        half_period: f64,
        wanted: Columns,
    ) -> Option<SampledMotion> {
        let count = self.names.len() + 3;
        let (&first, &last) = (times.first()?, times.last()?);
        let finite = parameters.iter().chain(&start).all(|value| value.is_finite());
        if parameters.len() != self.names.len() || !finite {
            return None;
        }
        // Coordinate and its derivatives, then velocity and its derivatives.
        let mut state = vec![0.0; 2 * count];
        (state[0], state[count]) = (start[0], start[1]);
        (state[count - 2], state[2 * count - 1]) = (1.0, 1.0);
        let is_displacement = wanted == Columns::Of(Quantity::Displacement);
        let kept_states = if is_displacement { count } else { 2 * count };
        let mut motion = SampledMotion::default();
        let mut columns = vec![Vec::with_capacity(times.len()); kept_states];
        let mut accelerations = vec![Vec::with_capacity(times.len()); count];
        let mut numbers: BTreeMap<Symbol, f64> =
            self.names.iter().copied().zip(parameters.iter().copied()).collect();
        let (mut time, mut next) = (first, 0);
        let mut arguments = vec![0.0, 0.0, 0.0];
        arguments.extend(parameters);
        let coefficients = arguments.len();
        let symbols: Vec<Symbol> =
            self.powers.iter().flat_map(PowerTerm::symbols).copied().collect();
        arguments.resize(coefficients + symbols.len(), 0.0);
        // The direction of a start at rest needs the powers of the spring.
        let scale = half_period / std::f64::consts::PI;
        let largest = start[0].hypot(start[1] * scale);
        self.set_powers(&mut arguments, coefficients, [largest, largest / scale]);
        let mut run = Run { scratch: vec![], values: vec![0.0; count] };
        let mut is_upward = start[1] > 0.0;
        let mut solvers: Vec<Option<Solver>> = vec![None; self.sides.len()];
        for swing in 0..MOST_HALF_SWINGS {
            self.set_point(&mut arguments, &state, time);
            if swing > 0 || start[1] == 0.0 {
                let before = run.acceleration(&self.sides[self.side(is_upward)], &arguments);
                let [up, down] = [true, false]
                    .map(|up| run.acceleration(&self.sides[self.side(up)], &arguments));
                let after = match (up > 0.0, down < 0.0) {
                    (true, false) => up,
                    (false, true) => down,
                    // Both sides lead back: friction holds the body.
                    (false, false) if self.is_driven => return None,
                    (false, false) => {
                        motion.rest = Some(time);
                        break;
                    }
                    (true, true) => before,
                };
                is_upward = after > 0.0;
                if swing > 0 {
                    let ratio = if before == 0.0 { 1.0 } else { after / before };
                    state[count + 1..].iter_mut().for_each(|change| *change *= ratio);
                }
                state[count] = 0.0;
            }
            let side = self.side(is_upward);
            if !self.powers.is_empty() {
                // As for a harmonic motion, where the scale is 1/w: X^2 = x^2 + (v/w)^2, V^2 = v^2 + (a/w)^2.
                let (x, v) = (state[0], state[count]);
                let acceleration = run.acceleration(&self.sides[side], &arguments);
                let largest = x.hypot(v * scale);
                let fastest = v.hypot(acceleration * scale);
                self.set_powers(&mut arguments, coefficients, [largest, fastest]);
                numbers
                    .extend(symbols.iter().copied().zip(arguments[coefficients..].iter().copied()));
                solvers[side] = None;
            }
            let solver = match &mut solvers[side] {
                Some(known) => known,
                place => place.insert(self.sides[side].solver_with(&numbers)?),
            };
            let path = solver.solve([time, last], &state).ok()?;
            let mut kept = vec![];
            let from = columns[0].len();
            path.sample(&times[next..], &mut kept, &mut columns);
            next += kept.len();
            if wanted == Columns::Of(Quantity::Acceleration) {
                for (place, time) in (from..).zip(&kept) {
                    self.set_point_of(
                        &mut arguments,
                        [columns[0][place], columns[count][place]],
                        *time,
                    );
                    let gradient = run.gradient(&self.sides[side], &arguments);
                    accelerations[0].push(gradient[0]);
                    for change in 1..count {
                        // The start enters through x and v alone.
                        let own = gradient.get(change + 2).copied().unwrap_or(0.0);
                        let [by_x, by_v] = [gradient[1], gradient[2]];
                        let (z, u) = (columns[change][place], columns[count + change][place]);
                        accelerations[change].push(by_x * z + by_v * u + own);
                    }
                }
            }
            match path.reason() {
                PathEnd::Reached => break,
                PathEnd::Event(_) => {
                    time = path.end();
                    state = path.states_at(time)?;
                }
                _ => return None,
            }
            if swing + 1 == MOST_HALF_SWINGS {
                return None;
            }
        }
        let mut columns: Vec<Vec<f64>> = match wanted {
            Columns::Of(Quantity::Displacement) | Columns::OfPhase => columns,
            Columns::Of(Quantity::Velocity) => columns.split_off(count),
            Columns::Of(Quantity::Acceleration) => accelerations,
        };
        let has_coordinate = is_displacement || wanted == Columns::OfPhase;
        for (index, column) in columns.iter_mut().enumerate() {
            let at_rest = if has_coordinate && index < count { state[index] } else { 0.0 };
            column.resize(times.len(), at_rest);
        }
        motion.columns = columns;
        Some(motion)
    }

    /// Sets the coefficients of powers for these largest values of the coordinate and of the velocity.
    fn set_powers(&self, arguments: &mut [f64], from: usize, [largest, fastest]: [f64; 2]) {
        let mut place = from;
        for power in &self.powers {
            let size = if power.base == Base::Velocity { fastest } else { largest };
            let own = power.numbers(&arguments[3..from], size);
            arguments[place..place + own.len()].copy_from_slice(&own);
            place += own.len();
        }
    }

    fn side(&self, is_upward: bool) -> usize {
        usize::from(!is_upward).min(self.sides.len() - 1)
    }

    fn set_point(&self, arguments: &mut [f64], state: &[f64], time: f64) {
        self.set_point_of(arguments, [state[0], state[state.len() / 2]], time);
    }

    fn set_point_of(&self, arguments: &mut [f64], [x, v]: [f64; 2], time: f64) {
        arguments[..3].copy_from_slice(&[x, v, time]);
    }
}

/// Memory of a run.
struct Run {
    scratch: Vec<f64>,
    values: Vec<f64>,
}

impl Run {
    fn gradient(&mut self, side: &Side, arguments: &[f64]) -> &[f64] {
        side.acceleration.call(arguments, &mut self.scratch, &mut self.values);
        &self.values
    }

    fn acceleration(&mut self, side: &Side, arguments: &[f64]) -> f64 {
        self.gradient(side, arguments)[0]
    }
}

impl Side {
    fn new(
        law: &Law,
        acceleration: &Expr,
        (taken, powers): (&[Symbol], &[PowerTerm]),
        stops: Option<bool>,
    ) -> Result<Self, ExprError> {
        let (coordinate, time) = (law.coordinate, Symbol::new("t"));
        let velocity = coordinate.derivative();
        let count = law.parameters.len() + 2;
        let [z, u] = ["z", "u"].map(|stem| {
            let stem = fresh_stem(stem, taken);
            (0..count).map(move |index| Symbol::new(&format!("{stem}{index}"))).collect::<Vec<_>>()
        });
        // Names with primes are no states of a system.
        let speed = fresh("v", &[taken, &z, &u].concat());
        // The velocity in the powers is written out first by its own name.
        let finished = |expr: &Expr| -> Result<Expr, ExprError> {
            with_contact_roots(&written_out(expr, powers)?)?
                .substitute(velocity, &Expr::from(speed))
        };
        let renamed = finished(acceleration)?;
        let by_x = finished(&by_variable(acceleration, powers, (coordinate, Base::Coordinate))?)?;
        let by_v = finished(&by_variable(acceleration, powers, (velocity, Base::Velocity))?)?;
        let by_parameters: Vec<Expr> = law
            .parameters
            .iter()
            .map(|name| finished(&by_parameter(acceleration, powers, *name)?))
            .collect::<Result<_, _>>()?;
        let mut states = vec![coordinate];
        states.extend(&z);
        states.push(speed);
        states.extend(&u);
        let mut rights = vec![Expr::from(speed)];
        rights.extend(u.iter().map(|name| Expr::from(*name)));
        rights.push(renamed.clone());
        for (index, (z, u)) in z.iter().zip(&u).enumerate() {
            let mut parts = vec![&by_x * &Expr::from(*z), &by_v * &Expr::from(*u)];
            parts.extend(by_parameters.get(index).cloned());
            rights.push(Expr::sum(parts));
        }
        let names: Vec<Symbol> = law
            .parameters
            .iter()
            .copied()
            .chain(powers.iter().flat_map(PowerTerm::symbols).copied())
            .collect();
        let numbers = names.iter().map(|name| (*name, GENERIC)).collect();
        let system = System::new(&states, time, &rights, &numbers)
            .map_err(|_| ExprError::TooManyTerms(0))?;
        let event = |is_upward: bool| {
            let event = Event::stop(Expr::from(speed));
            if is_upward { event.falling() } else { event.rising() }
        };
        let events: Vec<Event> = stops.map(event).into_iter().collect();
        let tolerance = TOLERANCES[usize::from(!powers.is_empty())];
        let options = SystemOptions { tolerance, ..SystemOptions::default() };
        let mut values = vec![renamed, by_x, by_v];
        values.extend(by_parameters);
        let arguments = [&[coordinate, speed, time], names.as_slice()].concat();
        let acceleration =
            CompiledList::new(&values, &arguments).map_err(|_| ExprError::TooManyTerms(0))?;
        let solver = system.solver(&events, &options);
        Ok(Self { solver, equations: (states, rights), events, options, acceleration })
    }

    /// The solver with these numbers. Other places of corners, such as barriers, need other recurrences.
    fn solver_with(&self, numbers: &BTreeMap<Symbol, f64>) -> Option<Solver> {
        let anew = || {
            let (states, rights) = &self.equations;
            let system = System::new(states, Symbol::new("t"), rights, numbers).ok()?;
            Some(system.solver(&self.events, &self.options))
        };
        self.solver.with_numbers(numbers).or_else(anew)
    }
}

/// Writes `max(y, 0)^e` as `(y^2)^(e/2) H(y)` if e is not a whole number: in this form it is integrated through y = 0, as at the beginning and the
/// end of a contact.
fn with_contact_roots(expr: &Expr) -> Result<Expr, ExprError> {
    let depth = |node: &Expr| -> Option<(Expr, Expr)> {
        let Node::Power(base, exponent) = node.node() else { return None };
        let Node::Function(Function::Maximum, arguments) = base.node() else { return None };
        let is_whole = exponent.as_number().is_some_and(|number| number.is_integer());
        let zero = arguments.iter().position(|own| own.is_zero()).filter(|_| !is_whole)?;
        Some((arguments.get(1 - zero.min(1))?.clone(), exponent.clone()))
    };
    expr.fold(|node, children: &[Expr]| match (depth(node), node.node()) {
        (Some((depth, exponent)), _) => {
            let half = Expr::divide(&exponent, &Expr::from(2))?;
            let side = Expr::function(Function::Step, vec![depth.clone()])?;
            Ok(Expr::power(&depth.integer_power(2)?, &half)? * side)
        }
        (None, Node::Number(_) | Node::Symbol(_) | Node::Pi) => Ok(node.clone()),
        _ => node.with_children(children),
    })
}

/// Writes `abs(v)` and `sgn(v)` for one sign of the velocity.
fn on_side(acceleration: &Expr, velocity: Symbol, sign: i64) -> Result<Expr, ExprError> {
    let sign = Expr::from(sign);
    acceleration.fold(|expr, children: &[Expr]| match expr.node() {
        Node::Function(function, _) if children[0].as_symbol() == Some(velocity) => {
            match function {
                Function::Absolute => Ok(&sign * &children[0]),
                Function::Sign => Ok(sign.clone()),
                _ => expr.with_children(children),
            }
        }
        Node::Number(_) | Node::Symbol(_) => Ok(expr.clone()),
        _ => expr.with_children(children),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(law: &Law) -> Vec<f64> {
        let value = |name: &Symbol| match name.name() {
            "w" => 1.3,
            "beta" => 0.4,
            "b" => 0.3,
            "k" => 1.7,
            "n" => 1.6,
            "zeta" => 0.02,
            "c" => 0.05,
            "alpha" => 0.01,
            "d" => 0.02,
            "q" => 0.06,
            "r" => 0.05,
            "p" => 1.4,
            name => panic!("{name}"),
        };
        law.parameters.iter().map(value).collect()
    }

    #[test]
    fn derivatives_are_those_of_neighbouring_motions() {
        let times: Vec<f64> = (0..200).map(|index| 0.1 * f64::from(index)).collect();
        for law in Law::list(true) {
            let solver = MotionSolver::new(&law).unwrap();
            let mut all = values(&law);
            all.extend([0.9, 0.1]);
            for quantity in [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration] {
                let run = |all: &[f64]| {
                    let (own, start) = all.split_at(all.len() - 2);
                    solver.sample(own, [start[0], start[1]], &times, 2.4, quantity).unwrap().columns
                };
                let reference = run(&all);
                for index in 0..all.len() {
                    let step = 1e-5;
                    let [mut above, mut below] = [all.clone(), all.clone()];
                    above[index] += step;
                    below[index] -= step;
                    let [above, below] = [run(&above), run(&below)];
                    let size =
                        reference[index + 1].iter().fold(0.0_f64, |size, z| size.max(z.abs()));
                    let errors = (0..times.len()).map(|place| {
                        let slope = (above[0][place] - below[0][place]) / (2.0 * step);
                        (slope - reference[index + 1][place]).abs()
                    });
                    let worst = errors.fold(0.0, f64::max) / size;
                    // The rounding of a power follows the amplitude, which the derivatives leave out.
                    let allowed = if solver.powers.is_empty() { 1e-4 } else { 3e-3 };
                    assert!(worst < allowed, "{} by {index} of {quantity:?}: {worst}", law.name);
                }
            }
        }
    }
}

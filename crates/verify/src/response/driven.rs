//! The equation of a driven oscillator in the phase of its motion, ready for numbers.
//!
//! ```text
//! x'' + f(x, x', t; p) = 0,   theta = omega t,   omega = Omega(p)/n   ->   omega^2 X'' + f(X, omega X', theta/omega; p) = 0
//! ```
//!
//! In: an oscillator with exact numbers for all parameters but one, p, which varies, and how many
//! periods of the drive, n, a period of the motion takes. Out: f and its derivatives by x, x' and p
//! at a fixed phase as compiled functions. Time may occur only inside `sin`, `cos` and `tan`, as
//! `Omega*t + phase`; the frequencies found there must be whole multiples of one, Omega. If it does
//! not occur at all, omega is an unknown of every motion.

use num_integer::Integer as _;
use num_traits::{Signed, Zero};

use super::series::{PhaseEquations, SETTLING_TOLERANCE, TOLERANCE, solver_in_time};
use super::{MOST_HARMONICS, ResponseError};
use crate::exact::Rational;
use crate::exact::rational::to_f64;
use crate::expr::{CompiledFunction, CompiledFunctions, Expr, Function, Node, SampledFunctions};
use crate::oscillator::Oscillator;
use crate::symbol::{Symbol, fresh, fresh_stem};
use crate::system::{Path, PathEnd, Solver, Variations, solve_together};

/// A driven equation of which one parameter varies.
#[derive(Clone, Debug)]
pub struct Driven {
    /// The frequency of the drive in the parameter.
    pub frequency: Expr,
    /// The parameter that varies.
    pub parameter: Symbol,
    /// Periods of the drive in a period of the motion.
    pub periods: usize,
    /// Whether there is no drive: the frequency of a motion is then an unknown, and `frequency` is
    /// its name.
    pub self_excited: bool,
    /// f(x, x', theta; p), with the sides of the jumps as further arguments if there are any.
    force: CompiledFunction,
    jumps: Vec<Jump>,
    /// f with its derivatives by x, x' and p.
    with_slopes: CompiledFunctions<4>,
    /// f(x, x', t; p), as it was given.
    in_time: CompiledFunction,
    /// The motion, and the motion with its variations, as Taylor series; `None` if there is a jump
    /// or no series.
    series: [Option<Solver>; 2],
    /// The motion as Taylor series of fewer orders, for simulations that are to settle.
    short_series: Option<Solver>,
    /// The motion as first-order equations in its phase.
    pub(super) in_phase: PhaseEquations,
    /// omega(p) and its derivative.
    base: [CompiledFunction; 2],
    /// Whether the force is even in the velocity.
    pub undamped: bool,
    /// Whether the force is the sum of one that does not depend on the phase and one of the phase alone.
    drive_is_added: bool,
    /// The expressions that change their signs at the corners of f(x, x', t; p).
    corners: Vec<CompiledFunction>,
    /// Whether the force has no corner or jump: no `abs`, `sgn`, `H`, `max` or `min`.
    pub smooth: bool,
}

/// A motion to be followed: position and velocity at a time, the parameter and the duration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedStart {
    /// Position and velocity.
    pub start: [f64; 2],
    /// The time at the start.
    pub begin: f64,
    /// The parameter.
    pub parameter: f64,
    /// The duration.
    pub duration: f64,
}

/// A line in the plane of position and velocity on which the force jumps, `n_x x + n_v x' = c(p)`;
/// n_v is one, or n_x where n_v is zero.
#[derive(Clone, Debug)]
struct Jump {
    normal: [f64; 2],
    /// c, and its derivative by p.
    level: [CompiledFunction; 2],
}

/// The line `normal . (x, v) = level`, or with n_x = 1 if n_v is zero, in exact numbers and
/// symbols.
#[derive(Clone, Debug, PartialEq)]
struct SwitchingLine {
    normal: [Rational; 2],
    level: Expr,
}

/// The argument of a part of a force that jumps where the argument changes its sign, if the
/// argument contains position or velocity.
fn argument_of_step<'a>(part: &'a Expr, oscillator: &Oscillator) -> Option<&'a Expr> {
    let Node::Function(Function::Sign | Function::Step, arguments) = part.node() else {
        return None;
    };
    let moves = |argument: &&Expr| {
        argument.contains(oscillator.coordinate) || argument.contains(oscillator.velocity())
    };
    arguments.first().filter(moves)
}

/// A force with the steps along some lines on this side.
fn on_side(
    force: &Expr,
    side: &Expr,
    is_meant: &impl Fn(&Expr) -> Result<Option<bool>, ResponseError>,
) -> Result<Expr, ResponseError> {
    force.fold(|part, parts: &[Expr]| match (part.node(), parts) {
        (Node::Function(function @ (Function::Sign | Function::Step), arguments), [_]) => {
            let Some(grows) = is_meant(&arguments[0])? else {
                return Ok(part.with_children(parts)?);
            };
            let sign = if grows { side.clone() } else { -side };
            match function {
                Function::Sign => Ok(sign),
                _ => Ok(Expr::divide(&(Expr::from(1) + sign), &Expr::from(2))?),
            }
        }
        _ => Ok(part.with_children(parts)?),
    })
}

/// Whether an argument of a step is zero on this line, and then whether it grows across it.
fn grows_across(
    argument: &Expr,
    line: &SwitchingLine,
    oscillator: &Oscillator,
) -> Result<Option<bool>, ResponseError> {
    let found = line_of(argument, oscillator)?.filter(|(own, _)| own == line);
    Ok(found.map(|(_, grows)| grows))
}

/// Whether the force jumps across a line on which steps in it change. Friction does; a stop `(x -
/// 1)*H(x - 1)` does not, however it is written, because the factor of its step vanishes there.
fn jumps_across(
    force: &Expr,
    line: &SwitchingLine,
    oscillator: &Oscillator,
    parameter: Symbol,
) -> Result<bool, ResponseError> {
    let (position, velocity) = (oscillator.coordinate, oscillator.velocity());
    let [by_position, by_velocity] = &line.normal;
    let (name, on_line) = match by_velocity.is_zero() {
        true => (position, line.level.clone()),
        false => {
            (velocity, &line.level - &(Expr::number(by_position.clone()) * Expr::from(position)))
        }
    };
    let on = |side: i64| -> Result<Expr, ResponseError> {
        let is_line = |argument: &Expr| grows_across(argument, line, oscillator);
        Ok(on_side(force, &Expr::from(side), &is_line)?.substitute(name, &on_line)?)
    };
    let jump = (&on(1)? - &on(-1)?).expand()?;
    if jump.is_zero() {
        return Ok(false);
    }
    let arguments = [position, velocity, Symbol::new("t"), parameter];
    let terms: Vec<CompiledFunction> = jump
        .terms()
        .iter()
        .map(|term| CompiledFunction::new(term, &arguments))
        .collect::<Result<_, _>>()?;
    Ok(!cancel(&terms))
}

/// Whether the sum of terms vanishes, to rounding, at all positions, velocities, times and
/// parameters that are tried.
fn cancel(terms: &[CompiledFunction]) -> bool {
    const PLACES: i32 = 24;
    const ROUNDING: f64 = 1e-12;
    let mut told = false;
    for index in 0..PLACES {
        // The points are distinct and not special.
        let number =
            |step: f64, from: f64, width: f64| from + width * (step * f64::from(index)).fract();
        let at = [
            number(0.618_034, -4.0, 8.0),
            number(0.414_214, -4.0, 8.0),
            number(0.732_051, 0.0, 7.0),
            number(0.236_068, 0.05, 3.0),
        ];
        let values: Vec<f64> = terms.iter().map(|term| term.call(&at)).collect();
        let size: f64 = values.iter().map(|value| value.abs()).sum();
        // Terms may all vanish at a point, which then decides nothing.
        if size > 0.0 && size.is_finite() {
            told = true;
            if values.iter().sum::<f64>().abs() > ROUNDING * size {
                return false;
            }
        }
    }
    told
}

/// The line on which the argument of a jump is zero, and whether it grows across it; `None` if that
/// is not a fixed line in the plane of position and velocity.
fn line_of(
    argument: &Expr,
    oscillator: &Oscillator,
) -> Result<Option<(SwitchingLine, bool)>, ResponseError> {
    let (position, velocity) = (oscillator.coordinate, oscillator.velocity());
    let factor = |name: Symbol| -> Result<Option<Rational>, ResponseError> {
        Ok(argument.differentiate(name)?.expand()?.as_number().cloned())
    };
    let (Some(by_position), Some(by_velocity)) = (factor(position)?, factor(velocity)?) else {
        return Ok(None);
    };
    let over = if by_velocity.is_zero() { by_position.clone() } else { by_velocity.clone() };
    if over.is_zero() {
        return Ok(None);
    }
    let rest = argument.substitute(velocity, &Expr::zero())?.substitute(position, &Expr::zero())?;
    let level = Expr::divide(&-rest, &Expr::number(over.clone()))?.expand()?;
    if level.contains(Symbol::new("t")) {
        return Ok(None);
    }
    let grows = over.is_positive();
    let normal = [&by_position / &over, &by_velocity / &over];
    Ok(Some((SwitchingLine { normal, level }, grows)))
}

/// The force with a symbol for the side, 1 or -1, in place of each jump, and the lines of the
/// jumps; the force unchanged if it has no jumps. A step across which the force is continuous stays
/// as it is.
fn with_sides(
    oscillator: &Oscillator,
    parameter: Symbol,
    side: impl Fn(usize) -> Symbol,
) -> Result<(Expr, Vec<SwitchingLine>), ResponseError> {
    let mut force = oscillator.force.expand()?;
    let mut lines: Vec<SwitchingLine> = Vec::new();
    for term in force.terms() {
        for argument in term.unique_nodes().filter_map(|part| argument_of_step(part, oscillator)) {
            match line_of(argument, oscillator)? {
                Some((line, _)) if !lines.contains(&line) => lines.push(line),
                None if argument.contains(oscillator.velocity()) => {
                    return Err(ResponseError::Jump(term.to_string()));
                }
                _ => {}
            }
        }
    }
    // Single terms may jump although their sum does not.
    let mut jumping = Vec::new();
    for line in lines {
        if jumps_across(&force, &line, oscillator, parameter)? {
            jumping.push(line);
        }
    }
    if jumping.is_empty() {
        return Ok((oscillator.force.clone(), jumping));
    }
    for (index, line) in jumping.iter().enumerate() {
        let is_line = |argument: &Expr| grows_across(argument, line, oscillator);
        force = on_side(&force, &Expr::from(side(index)), &is_line)?;
    }
    Ok((force, jumping))
}

impl Driven {
    /// Prepares an oscillator whose only parameter is the one that varies; it is self-excited if
    /// time does not occur.
    ///
    /// # Errors
    /// A drive that is not periodic; several frequencies that are not multiples of one; a
    /// derivative that cannot be written.
    pub fn new(
        oscillator: &Oscillator,
        parameter: Symbol,
        periods: usize,
    ) -> Result<Self, ResponseError> {
        if !oscillator.force.contains(Symbol::new("t")) {
            let names: Vec<Symbol> = oscillator.names().into_iter().chain([parameter]).collect();
            return Ok(Self {
                frequency: Expr::from(fresh("omega", &names)),
                self_excited: true,
                ..Self::of_frequency(oscillator, Expr::from(1), parameter, 1)?
            });
        }
        let states = [oscillator.coordinate, oscillator.velocity()];
        let frequency = drive_frequency(std::slice::from_ref(&oscillator.force), &states)?;
        Self::of_frequency(oscillator, frequency, parameter, periods)
    }

    /// Prepares an oscillator whose motions have this frequency, driven or free.
    pub(super) fn of_frequency(
        oscillator: &Oscillator,
        frequency: Expr,
        parameter: Symbol,
        periods: usize,
    ) -> Result<Self, ResponseError> {
        let time = Symbol::new("t");
        let (position, velocity) = (oscillator.coordinate, oscillator.velocity());
        let names: Vec<Symbol> =
            oscillator.names().into_iter().chain([velocity, parameter]).collect();
        let phase = fresh("theta", &names);
        let stem = fresh_stem("side", &names);
        let side = |index: usize| Symbol::new(&format!("{stem}{index}"));
        let (force, lines) = with_sides(oscillator, parameter, side)?;
        let lines_are_empty = lines.is_empty();
        let base = Expr::divide(&frequency, &Expr::from(i64::try_from(periods).unwrap_or(1)))?;
        let moment = Expr::divide(&Expr::from(phase), &base)?;
        let force = in_phase(&force, time, &moment)?;
        let own = [position, velocity, phase, parameter];
        let arguments: Vec<Symbol> = own.into_iter().chain((0..lines.len()).map(side)).collect();
        let compiled = |expression: &Expr| {
            CompiledFunction::new(expression, &arguments).map_err(ResponseError::from)
        };
        let slope = |by: Symbol| force.differentiate(by);
        let [by_position, by_velocity, by_parameter] =
            [slope(position)?, slope(velocity)?, slope(parameter)?];
        let with_slopes = [&force, &by_position, &by_velocity, &by_parameter];
        let drive_is_added =
            lines_are_empty && !by_position.contains(phase) && !by_velocity.contains(phase);
        let undamped = oscillator
            .parts()
            .is_ok_and(|parts| parts.damping.is_zero() && !parts.forcing.contains(velocity));
        Ok(Self {
            with_slopes: CompiledFunctions::new(with_slopes, &arguments)?,
            drive_is_added,
            force: compiled(&force)?,
            jumps: lines
                .into_iter()
                .map(|SwitchingLine { normal, level }| {
                    Ok::<Jump, ResponseError>(Jump {
                        normal: normal.map(|factor| to_f64(&factor)),
                        level: [
                            CompiledFunction::new(&level, &[parameter])?,
                            CompiledFunction::new(&level.differentiate(parameter)?, &[parameter])?,
                        ],
                    })
                })
                .collect::<Result<_, _>>()?,
            series: match lines_are_empty {
                true => [false, true]
                    .map(|varied| solver_in_time(oscillator, parameter, varied, TOLERANCE)),
                false => [None, None],
            },
            short_series: lines_are_empty
                .then(|| solver_in_time(oscillator, parameter, false, SETTLING_TOLERANCE))
                .flatten(),
            in_time: CompiledFunction::new(
                &oscillator.force,
                &[position, velocity, time, parameter],
            )?,
            in_phase: PhaseEquations {
                states: vec![position, velocity],
                phase,
                right: vec![
                    Expr::divide(&Expr::from(velocity), &base)?,
                    -Expr::divide(&force, &base)?,
                ],
            },
            base: [
                CompiledFunction::new(&base, &[parameter])?,
                CompiledFunction::new(&base.differentiate(parameter)?, &[parameter])?,
            ],
            frequency,
            parameter,
            periods,
            self_excited: false,
            undamped,
            corners: corners_of(oscillator, parameter)?,
            smooth: !oscillator.force.contains_corner(),
        })
    }

    /// omega of the motion, that of the drive over a whole number; 1 if there is no drive.
    pub fn frequency_at(&self, parameter: f64) -> f64 {
        self.base[0].call(&[parameter])
    }

    /// The derivative of [omega](Self::frequency_at) by the parameter.
    pub fn frequency_slope(&self, parameter: f64) -> f64 {
        self.base[1].call(&[parameter])
    }

    /// The velocity at which the force jumps, as that of dry friction does at zero; `None` if it
    /// has no jump or other jumps.
    pub fn jump_speed(&self, parameter: f64) -> Option<f64> {
        match self.jumps.as_slice() {
            [jump] if jump.normal[0] == 0.0 => Some(jump.level[0].call(&[parameter])),
            _ => None,
        }
    }

    /// The derivative of that velocity by the parameter.
    pub fn jump_speed_slope(&self, parameter: f64) -> f64 {
        self.jumps.first().map_or(0.0, |jump| jump.level[1].call(&[parameter]))
    }

    /// The number of lines on which the force jumps.
    pub fn jumps(&self) -> usize {
        self.jumps.len()
    }

    /// Whether harmonic balance can treat the jumps: there are none, or there is one with the
    /// velocity and a drive.
    pub fn is_balanced(&self) -> bool {
        match self.jumps.as_slice() {
            [] => true,
            [jump] => jump.normal[0] == 0.0 && !self.self_excited,
            _ => false,
        }
    }

    /// The normal `(n_x, n_v)` of a jump, which lies on `n_x x + n_v x' = c`.
    pub fn normal(&self, index: usize) -> [f64; 2] {
        self.jumps[index].normal
    }

    /// The value of `n_x x + n_v x' - c` for a jump.
    pub fn height(&self, index: usize, [x, v]: [f64; 2], parameter: f64) -> f64 {
        let Jump { normal, level } = &self.jumps[index];
        // For a jump with the velocity alone the term 0 x is left out, so that the velocity c is
        // met exactly.
        match normal {
            [0.0, _] => v - level[0].call(&[parameter]),
            [by_position, by_velocity] => {
                by_position * x + by_velocity * v - level[0].call(&[parameter])
            }
        }
    }

    /// f at a position, a velocity and a phase of the motion.
    pub fn force(&self, at: &[f64; 4]) -> f64 {
        match self.jumps.is_empty() {
            true => self.force.call(at),
            false => self.force_on(at, &self.sides(at)),
        }
    }

    /// Its derivatives by position, velocity and parameter, the phase being fixed.
    pub fn slopes(&self, at: &[f64; 4]) -> [f64; 3] {
        self.force_with_slopes(at).1
    }

    /// The force on a body at rest, as a function of its place, on average over this many phases of the
    /// drive: one evaluation a place if the drive does not depend on it.
    pub(super) fn mean_force(&self, parameter: f64, phases: u32) -> impl Fn(f64) -> f64 {
        let at = move |x: f64, phase: u32| {
            let part = (f64::from(phase) + 0.5) / f64::from(phases);
            self.force(&[x, 0.0, std::f64::consts::TAU * part * self.periods as f64, parameter])
        };
        let mean =
            move |x: f64| (0..phases).map(|phase| at(x, phase)).sum::<f64>() / f64::from(phases);
        let drive =
            self.drive_is_added.then(|| mean(0.0) - at(0.0, 0)).filter(|drive| drive.is_finite());
        move |x: f64| match drive {
            Some(drive) => at(x, 0) + drive,
            None => mean(x),
        }
    }

    /// f, and its derivatives by position, velocity and parameter, the phase being fixed.
    pub fn force_with_slopes(&self, at: &[f64; 4]) -> (f64, [f64; 3]) {
        let [force, slopes @ ..] = match self.jumps.is_empty() {
            true => self.with_slopes.call(at),
            false => self.with_slopes_on(at, &self.sides(at)),
        };
        (force, slopes)
    }

    /// f and its derivatives by position, velocity and parameter at these phases, of positions,
    /// velocities and parameters as arguments 0, 1 and 3; `None` if f jumps.
    pub(super) fn sampled_with_slopes(&self, phases: &[f64]) -> Option<SampledFunctions<4>> {
        self.sampled(&self.with_slopes, phases)
    }

    /// f at these phases, as [`Driven::sampled_with_slopes`].
    pub(super) fn sampled_force(&self, phases: &[f64]) -> Option<SampledFunctions<1>> {
        self.sampled(&self.force.clone().into(), phases)
    }

    fn sampled<const N: usize>(
        &self,
        functions: &CompiledFunctions<N>,
        phases: &[f64],
    ) -> Option<SampledFunctions<N>> {
        let sampled = || SampledFunctions::new(functions.clone(), phases.len(), &[(2, phases)]);
        self.jumps.is_empty().then(sampled)
    }

    /// f on these sides of its jumps, 1 above and -1 below.
    pub fn force_on(&self, at: &[f64; 4], sides: &[f64]) -> f64 {
        with_arguments(at, sides, self.jumps.len(), |arguments| self.force.call(arguments))
    }

    /// The derivatives of f on these sides.
    pub fn slopes_on(&self, at: &[f64; 4], sides: &[f64]) -> [f64; 3] {
        let [_, slopes @ ..] = self.with_slopes_on(at, sides);
        slopes
    }

    fn with_slopes_on(&self, at: &[f64; 4], sides: &[f64]) -> [f64; 4] {
        with_arguments(at, sides, self.jumps.len(), |arguments| self.with_slopes.call(arguments))
    }

    /// The side of each jump at a state, 1 or -1; zero on the jump itself.
    fn sides(&self, at: &[f64; 4]) -> Vec<f64> {
        let side = |height: f64| if height == 0.0 { 0.0 } else { height.signum() };
        (0..self.jumps.len()).map(|index| side(self.height(index, [at[0], at[1]], at[3]))).collect()
    }

    /// Whether the drive is a term that depends on no place and no velocity.
    pub(super) fn drive_is_added(&self) -> bool {
        self.drive_is_added
    }

    /// Whether a motion is followed by its Taylor series.
    pub(super) fn has_series(&self) -> bool {
        self.series[0].is_some()
    }

    /// Follows motions side by side by their Taylor series; `None` for one that has none all the
    /// way.
    pub fn by_series(&self, motions: &[TimedStart]) -> Vec<Option<Path>> {
        self.paths(&self.series[0], motions, |start| start.to_vec())
    }

    /// Follows motions side by side as [`Self::by_series`] does, to the accuracy that simulations need
    /// which are to settle, for less than half of the work.
    pub(super) fn by_short_series(&self, motions: &[TimedStart]) -> Vec<Option<Path>> {
        self.paths(&self.short_series, motions, |start| start.to_vec())
    }

    /// Follows motions with their variations side by side, whose states are position, velocity and
    /// the two columns of M(t).
    pub fn varied_by_series(&self, motions: &[TimedStart]) -> Vec<Option<Path>> {
        self.paths(&self.series[1], motions, |start| Variations::start(start, false))
    }

    fn paths(
        &self,
        solver: &Option<Solver>,
        motions: &[TimedStart],
        begin: impl Fn(&[f64]) -> Vec<f64>,
    ) -> Vec<Option<Path>> {
        let prepared = |motion: &TimedStart| {
            let numbers = [(self.parameter, motion.parameter)].into();
            let solver = solver.as_ref()?.with_numbers(&numbers)?;
            let times = [motion.begin, motion.begin + motion.duration];
            Some((solver, times, begin(&motion.start)))
        };
        let prepared: Vec<_> = motions.iter().map(prepared).collect();
        let runs = prepared.iter().flatten();
        let runs = runs.map(|(solver, times, start)| (solver, *times, start.as_slice()));
        let mut paths = solve_together(&runs.collect::<Vec<_>>()).into_iter();
        let reached = |path: &Path| path.reason() == PathEnd::Reached;
        let path = |run: &Option<_>| run.as_ref().and_then(|_| paths.next()?.ok().filter(reached));
        prepared.iter().map(path).collect()
    }

    /// The number of corners of the force.
    pub fn corners(&self) -> usize {
        self.corners.len()
    }

    /// The expressions that change their signs at corners, in time.
    pub fn corner(&self, index: usize, at: &[f64; 4]) -> f64 {
        self.corners[index].call(at)
    }

    /// f as it was given, in time.
    pub fn force_in_time(&self, at: &[f64; 4]) -> f64 {
        self.in_time.call(at)
    }
}

/// The expressions that change their signs at the corners of a force, each once.
fn corners_of(
    oscillator: &Oscillator,
    parameter: Symbol,
) -> Result<Vec<CompiledFunction>, ResponseError> {
    let own = [oscillator.coordinate, oscillator.velocity(), Symbol::new("t")];
    let mut found: Vec<Expr> = Vec::new();
    for node in oscillator.force.unique_nodes() {
        let Node::Function(function, arguments) = node.node() else { continue };
        let argument = match arguments.as_slice() {
            [only] if function.has_corner() => only.clone(),
            [one, other] if function.has_corner() => one - other,
            _ => continue,
        };
        if own.iter().any(|name| argument.contains(*name)) && !found.contains(&argument) {
            found.push(argument);
        }
    }
    let [position, velocity, time] = own;
    let arguments = [position, velocity, time, parameter];
    let compiled = found.iter().map(|corner| CompiledFunction::new(corner, &arguments));
    Ok(compiled.collect::<Result<_, _>>()?)
}

/// Calls a function with the arguments of the force and the sides of a number of jumps behind them.
fn with_arguments<T>(
    [x, v, phase, p]: &[f64; 4],
    sides: &[f64],
    jumps: usize,
    function: impl Fn(&[f64]) -> T,
) -> T {
    match (jumps, sides) {
        (0, _) => function(&[*x, *v, *phase, *p]),
        (1, [side]) => function(&[*x, *v, *phase, *p, *side]),
        (2, [one, other]) => function(&[*x, *v, *phase, *p, *one, *other]),
        _ => {
            let all: Vec<f64> = [*x, *v, *phase, *p].iter().chain(sides).copied().collect();
            function(&all)
        }
    }
}

/// The expression with the phase in place of time; the arguments of `sin` and the like are written
/// out, so that `Omega*theta/Omega` is `theta`.
pub(super) fn in_phase(
    expression: &Expr,
    time: Symbol,
    moment: &Expr,
) -> Result<Expr, ResponseError> {
    Ok(expression.fold(|node, children: &[Expr]| match node.node() {
        Node::Symbol(name) if *name == time => Ok(moment.clone()),
        Node::Function(..) if node.contains(time) => {
            let arguments: Result<Vec<Expr>, _> = children.iter().map(Expr::expand).collect();
            node.with_children(&arguments?)
        }
        _ if children.is_empty() => Ok(node.clone()),
        _ => node.with_children(children),
    })?)
}

/// Largest number of waves of a drive in the common period of all drives: a motion has twice as many
/// harmonics at most.
const MOST_WAVES: u32 = MOST_HARMONICS as u32 / 2;

/// The frequency of which all frequencies of the drive are whole multiples, where these are the
/// names of the states.
///
/// # Errors
/// [`ResponseError`] if there is no drive, or none with one period.
pub(super) fn drive_frequency(forces: &[Expr], states: &[Symbol]) -> Result<Expr, ResponseError> {
    let time = Symbol::new("t");
    if !forces.iter().any(|force| force.contains(time)) {
        return Err(ResponseError::NoDrive);
    }
    let mut found: Vec<Expr> = Vec::new();
    for term in forces.iter().flat_map(|force| force.terms().to_vec()) {
        // Whether time stands outside of every periodic function.
        let bare = term.fold(|node, children: &[bool]| match node.node() {
            Node::Symbol(name) => Ok::<bool, ResponseError>(*name == time),
            Node::Function(Function::Sin | Function::Cos | Function::Tan, arguments)
                if node.contains(time) =>
            {
                let frequency = arguments.first().map(|argument| argument.differentiate(time));
                let frequency = frequency.unwrap_or_else(|| Ok(Expr::zero()))?.expand()?;
                if states.iter().chain([&time]).any(|name| frequency.contains(*name)) {
                    return Ok(true);
                }
                found.push(frequency);
                Ok(false)
            }
            _ => Ok(children.contains(&true)),
        })?;
        if bare {
            return Err(ResponseError::NotPeriodic(term.to_string()));
        }
    }
    let Some(first) = found.first().cloned() else {
        return Err(ResponseError::NoDrive);
    };
    let mut common: Option<Rational> = None;
    let mut fastest = (Rational::zero(), first.clone());
    for frequency in &found {
        let ratio = Expr::divide(frequency, &first)?.expand()?;
        let Some(ratio) = ratio.as_number().filter(|ratio| !ratio.is_zero()) else {
            return Err(ResponseError::TwoFrequencies([first.to_string(), frequency.to_string()]));
        };
        let ratio = ratio.abs();
        if ratio > fastest.0 {
            fastest = (ratio.clone(), frequency.clone());
        }
        common = Some(match common {
            None => ratio,
            Some(common) => {
                Rational::new(common.numer().gcd(ratio.numer()), common.denom().lcm(ratio.denom()))
            }
        });
    }
    let factor = common.unwrap_or_else(num_traits::One::one);
    let waves = &fastest.0 / &factor;
    if waves > Rational::from_integer(MOST_WAVES.into()) {
        let frequencies = [first.to_string(), fastest.1.to_string()];
        return Err(ResponseError::FarFrequencies { frequencies, waves: waves.to_string() });
    }
    let frequency = Expr::number(factor) * first;
    Ok(if frequency.has_leading_minus() { -frequency } else { frequency })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frequency(text: &str) -> Result<String, String> {
        let oscillator = Oscillator::parse(text).unwrap();
        let states = [oscillator.coordinate, oscillator.velocity()];
        let found = drive_frequency(&[oscillator.force], &states);
        found.map(|found| found.to_string()).map_err(|error| error.to_string())
    }

    #[test]
    fn the_drive_has_one_frequency() {
        for (text, expected) in [
            ("x'' + x - F*cos(Omega*t) = 0", "Omega"),
            ("x'' + x - F*cos(2*t)^2 = 0", "2"),
            ("x'' + x*(1 + sin(3*Omega*t + 1)) = cos(2*Omega*t)", "Omega"),
            ("x'' + x = cos(t/2) + sin(t/3)", "1/6"),
            ("x'' + x = sgn(sin(Omega*t - x))", "Omega"),
            ("x'' + x = cos(-k*t)", "k"),
            ("x'' + x = exp(cos((b + c)*t))", "b + c"),
        ] {
            assert_eq!(frequency(text).as_deref(), Ok(expected), "{text}");
        }
        for (text, words) in [
            ("x'' + x = 0", "no drive"),
            ("x'' + x = exp(-t)", "exp(-t)"),
            ("x'' + x = t*cos(t)", "t*cos(t)"),
            ("x'' + x = cos(t^2)", "cos(t^2)"),
            ("x'' + x = cos(t) + cos(pi*t)", "no whole multiples"),
            ("x'' + x = cos(Omega*t) + cos(t)", "no whole multiples"),
            ("x'' + x = cos(Omega*t) + cos(1.37*Omega*t)", "holds 137 waves"),
        ] {
            let refused = frequency(text).unwrap_err();
            assert!(refused.contains(words), "{text}: {refused}");
        }
    }

    /// A step counts by the value of its factor on the line, in whatever form.
    #[test]
    fn a_step_is_a_jump_where_its_factor_is_not_zero() {
        for (force, jumps) in [
            ("20*(x - 0.5)*H(x - 0.5)", 0),
            ("5*(x - 1)*H(x - 1) + 5*(x + 1)*H(-x - 1)", 0),
            ("(x^2 - p^2)*H(x - p)", 0),
            ("(exp(x - p) - 1)*H(x - p)", 0),
            ("(sqrt(x) - sqrt(p))*cos(t)*H(2*x - 2*p)", 0),
            ("(x' + x/2 - 1/10)*H(x' + x/2 - 1/10)", 0),
            ("(x' - p)*sgn(x' - p)", 0),
            ("x*H(x - 0.5)", 1),
            ("(x - 0.5)*H(x - 0.5) + sgn(x)/1000", 1),
            ("(x - 0.5)*H(x - 0.51)", 1),
            ("(x - 0.5)*(H(x - 0.5) + sgn(x'))", 1),
            ("(exp(x - p) - p)*H(x - p)", 1),
            ("sgn(x' - p) + sgn(x' + x)*x'^2", 2),
        ] {
            let oscillator =
                Oscillator::parse(&format!("x'' + x'/5 + x + {force} = cos(t)")).unwrap();
            let driven = Driven::new(&oscillator, "p".into(), 1).unwrap();
            assert_eq!(driven.jumps(), jumps, "{force}");
        }
    }

    #[test]
    fn the_phase_takes_the_place_of_time() {
        let oscillator = Oscillator::parse("x'' + x'/5 + x + x^3 = 2*cos(3*Omega*t + x)").unwrap();
        let driven = Driven::new(&oscillator, "Omega".into(), 2).unwrap();
        let (x, v, theta, omega) = (0.3, -0.7, 1.1, 1.7);
        let base = driven.frequency_at(omega);
        assert!((base - 3.0 * omega / 2.0).abs() < 1e-15 && driven.frequency_slope(omega) == 1.5);
        let there = driven.force(&[x, v, theta, omega]);
        let expected = v / 5.0 + x + x * x * x - 2.0 * (2.0 * theta + x).cos();
        assert!((there - expected).abs() < 1e-14);
        assert!((driven.force_in_time(&[x, v, theta / base, omega]) - expected).abs() < 1e-14);
        let slopes = driven.slopes(&[x, v, theta, omega]);
        let by_position = 1.0 + 3.0 * x * x + 2.0 * (2.0 * theta + x).sin();
        assert!((slopes[0] - by_position).abs() < 1e-14 && slopes[1] == 0.2 && slopes[2] == 0.0);
    }
}

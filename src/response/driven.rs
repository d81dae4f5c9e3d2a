//! The equation of a driven oscillator in the phase of its motion, ready for numbers.
//!
//! ```text
//! x'' + f(x, x', t; p) = 0,   theta = omega t,   omega = Omega(p)/n   ->   omega^2 X'' + f(X, omega X', theta/omega; p) = 0
//! ```
//!
//! In: an oscillator with exact numbers for all parameters but one, p, which varies, and how many periods of the drive, n, a period
//! of the motion takes. Out: f and its derivatives by x, x' and p at a fixed phase as straight lists of operations. Time may stand
//! inside `sin`, `cos` and `tan` alone, as `Omega*t + phase`; the frequencies found there must be whole multiples of one, Omega.
//! Where it does not occur at all, omega is an unknown of every motion.

use num_integer::Integer as _;
use num_traits::{Signed, Zero};

use super::ResponseError;
use crate::exact::Rational;
use crate::expr::{CompiledFunction, Expr, Function, Node};
use crate::oscillator::Oscillator;
use crate::symbol::{Symbol, fresh};

/// A driven equation of which one parameter varies.
#[derive(Clone, Debug)]
pub struct Driven {
    /// The frequency of the drive in the parameter.
    pub frequency: Expr,
    /// The parameter that varies.
    pub parameter: Symbol,
    /// Periods of the drive in a period of the motion.
    pub periods: usize,
    /// Whether nothing drives it: the frequency of a motion is then an unknown, for which `frequency` is a name.
    pub self_excited: bool,
    /// f(x, x', theta; p) with the side of the jump that the velocity is on, where there is one.
    force: CompiledFunction,
    /// The velocity at which the force jumps, and its derivative by p.
    jump: Option<[CompiledFunction; 2]>,
    /// Its derivatives by x, x' and p.
    slopes: [CompiledFunction; 3],
    /// f(x, x', t; p), as it was given.
    in_time: CompiledFunction,
    /// omega(p) and its derivative.
    base: [CompiledFunction; 2],
    /// Whether it has no odd power of the velocity.
    pub undamped: bool,
    /// Whether the force has no corner or jump: no `abs`, `sgn`, `H`, `max` or `min`.
    pub smooth: bool,
}

/// The functions with a corner or a jump.
const CORNERS: [Function; 5] = [
    Function::Absolute,
    Function::Sign,
    Function::Step,
    Function::Maximum,
    Function::Minimum,
];

/// Whether a part of a force jumps where its argument, in which the velocity stands, changes its sign.
fn jumps(part: &Expr, velocity: Symbol) -> bool {
    match part.node() {
        Node::Function(Function::Sign | Function::Step, arguments) => {
            arguments.iter().any(|argument| argument.contains(velocity))
        }
        _ => false,
    }
}

/// Whether a term has a jump of its own size at the velocity zero alone, and none there: it is multiplied by a power of the velocity.
fn is_continuous(term: &Expr, velocity: Symbol) -> Result<bool, ResponseError> {
    let elsewhere = |part: &Expr| jumps(part, velocity) && part.children().any(|it| it.as_symbol() != Some(velocity));
    if term.unique_nodes().any(elsewhere) {
        return Ok(false);
    }
    let on_side = |side: i64| -> Result<Expr, ResponseError> {
        let chosen = term.fold(|part, parts: &[Expr]| match (part.node(), parts) {
            (Node::Function(function @ (Function::Sign | Function::Step), _), [argument])
                if argument.as_symbol() == Some(velocity) =>
            {
                Expr::function(*function, vec![argument.substitute(velocity, &Expr::from(side))?])
            }
            _ => part.with_children(parts),
        })?;
        Ok(chosen.substitute(velocity, &Expr::zero())?)
    };
    Ok((&on_side(1)? - &on_side(-1)?).is_zero())
}

/// The velocity at which the argument of a jump is zero, and whether it grows with the velocity; nothing where that is no velocity of its
/// own, the same at every place and time.
fn speed_of(argument: &Expr, oscillator: &Oscillator) -> Result<Option<(Expr, bool)>, ResponseError> {
    let velocity = oscillator.velocity();
    let factor = argument.differentiate(velocity)?.expand()?;
    let Some(number) = factor.as_number().filter(|number| !number.is_zero()) else {
        return Ok(None);
    };
    let grows = number.is_positive();
    let rest = argument.substitute(velocity, &Expr::zero())?;
    let speed = Expr::divide(&-rest, &factor)?.expand()?;
    let own = [oscillator.coordinate, Symbol::new("t")];
    Ok((!own.iter().any(|name| speed.contains(*name))).then_some((speed, grows)))
}

/// The force with a name for the side of the velocity, 1 or -1, in place of what jumps with it, and the velocity at which it does; the
/// force as it is where nothing jumps.
fn with_side(oscillator: &Oscillator, side: Symbol) -> Result<(Expr, Option<Expr>), ResponseError> {
    let velocity = oscillator.velocity();
    let mut speed: Option<Expr> = None;
    let mut replaced = Vec::new();
    for term in oscillator.force.expand()?.terms() {
        if !term.unique_nodes().any(|part| jumps(part, velocity)) || is_continuous(term, velocity)? {
            replaced.push(term.clone());
            continue;
        }
        let refused = || ResponseError::Jump(term.to_string());
        replaced.push(term.fold(|part, parts: &[Expr]| match (part.node(), parts) {
            (Node::Function(function @ (Function::Sign | Function::Step), _), [argument])
                if argument.contains(velocity) =>
            {
                let (own, grows) = speed_of(argument, oscillator)?.ok_or_else(refused)?;
                if speed.get_or_insert_with(|| own.clone()) != &own {
                    return Err(refused());
                }
                let sign = if grows { Expr::from(side) } else { -Expr::from(side) };
                match function {
                    Function::Sign => Ok(sign),
                    _ => Ok(Expr::divide(&(Expr::from(1) + sign), &Expr::from(2))?),
                }
            }
            _ => Ok(part.with_children(parts)?),
        })?);
    }
    Ok(match speed {
        Some(speed) => (Expr::sum(replaced), Some(speed)),
        None => (oscillator.force.clone(), None),
    })
}

impl Driven {
    /// Of an oscillator without other parameters than the one that varies; self-excited where time does not occur.
    ///
    /// # Errors
    /// A drive that is not periodic; several frequencies that are no multiples of one; a derivative that cannot be written.
    pub fn new(oscillator: &Oscillator, parameter: Symbol, periods: usize) -> Result<Self, ResponseError> {
        if !oscillator.force.contains(Symbol::new("t")) {
            let names: Vec<Symbol> = oscillator.names().into_iter().chain([parameter]).collect();
            let found = Self {
                frequency: Expr::from(fresh("omega", &names)),
                self_excited: true,
                ..Self::of_frequency(oscillator, Expr::from(1), parameter, 1)?
            };
            return match found.jump {
                Some(_) => Err(ResponseError::FreeJump),
                None => Ok(found),
            };
        }
        let frequency = drive_frequency(oscillator)?;
        Self::of_frequency(oscillator, frequency, parameter, periods)
    }

    /// Of an oscillator whose motions have this frequency, driven or free.
    pub(super) fn of_frequency(
        oscillator: &Oscillator,
        frequency: Expr,
        parameter: Symbol,
        periods: usize,
    ) -> Result<Self, ResponseError> {
        let time = Symbol::new("t");
        let (position, velocity) = (oscillator.coordinate, oscillator.velocity());
        let names: Vec<Symbol> = oscillator.names().into_iter().chain([velocity, parameter]).collect();
        let phase = fresh("theta", &names);
        let side = fresh("side", &names);
        let (force, speed) = with_side(oscillator, side)?;
        let base = Expr::divide(&frequency, &Expr::from(i64::try_from(periods).unwrap_or(1)))?;
        let moment = Expr::divide(&Expr::from(phase), &base)?;
        let force = in_phase(&force, time, &moment)?;
        let arguments = [position, velocity, phase, parameter, side];
        let compiled = |expression: &Expr| CompiledFunction::new(expression, &arguments).map_err(ResponseError::from);
        let slope = |by: Symbol| compiled(&force.differentiate(by)?);
        let undamped = oscillator
            .parts()
            .is_ok_and(|parts| parts.damping.is_zero() && !parts.forcing.contains(velocity));
        Ok(Self {
            slopes: [slope(position)?, slope(velocity)?, slope(parameter)?],
            force: compiled(&force)?,
            jump: match speed {
                Some(speed) => Some([
                    CompiledFunction::new(&speed, &[parameter])?,
                    CompiledFunction::new(&speed.differentiate(parameter)?, &[parameter])?,
                ]),
                None => None,
            },
            in_time: CompiledFunction::new(&oscillator.force, &[position, velocity, time, parameter])?,
            base: [
                CompiledFunction::new(&base, &[parameter])?,
                CompiledFunction::new(&base.differentiate(parameter)?, &[parameter])?,
            ],
            frequency,
            parameter,
            periods,
            self_excited: false,
            undamped,
            smooth: !CORNERS.iter().any(|corner| oscillator.force.contains_function(*corner)),
        })
    }

    /// omega: that of the motion, a whole part of that of the drive; 1 where there is no drive.
    pub fn frequency_at(&self, parameter: f64) -> f64 {
        self.base[0].call(&[parameter])
    }

    /// Its derivative by the parameter.
    pub fn frequency_slope(&self, parameter: f64) -> f64 {
        self.base[1].call(&[parameter])
    }

    /// The velocity at which the force jumps, if it does, as that of dry friction at zero.
    pub fn jump_speed(&self, parameter: f64) -> Option<f64> {
        self.jump.as_ref().map(|jump| jump[0].call(&[parameter]))
    }

    /// The derivative of that velocity by the parameter.
    pub fn jump_speed_slope(&self, parameter: f64) -> f64 {
        self.jump.as_ref().map_or(0.0, |jump| jump[1].call(&[parameter]))
    }

    /// f at a position, a velocity and a phase of the motion.
    pub fn force(&self, at: &[f64; 4]) -> f64 {
        self.force_on(at, self.side(at))
    }

    /// Its derivatives by position, velocity and parameter, the phase being fixed.
    pub fn slopes(&self, at: &[f64; 4]) -> [f64; 3] {
        self.slopes_on(at, self.side(at))
    }

    /// f as it is on this side of its jump, 1 above it and -1 below.
    pub fn force_on(&self, [x, v, phase, p]: &[f64; 4], side: f64) -> f64 {
        self.force.call(&[*x, *v, *phase, *p, side])
    }

    /// Its derivatives on this side.
    pub fn slopes_on(&self, [x, v, phase, p]: &[f64; 4], side: f64) -> [f64; 3] {
        self.slopes
            .each_ref()
            .map(|slope| slope.call(&[*x, *v, *phase, *p, side]))
    }

    /// The side of its jump that a velocity is on; zero at the jump itself.
    fn side(&self, at: &[f64; 4]) -> f64 {
        match self.jump_speed(at[3]) {
            Some(speed) if at[1] != speed => (at[1] - speed).signum(),
            _ => 0.0,
        }
    }

    /// f as it was given, in time.
    pub fn force_in_time(&self, at: &[f64; 4]) -> f64 {
        self.in_time.call(at)
    }
}

/// The expression with the phase in place of time; the arguments of `sin` and the like are written out, so that
/// `Omega*theta/Omega` is `theta`.
fn in_phase(expression: &Expr, time: Symbol, moment: &Expr) -> Result<Expr, ResponseError> {
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

/// The frequency of which all frequencies of the drive are whole multiples.
fn drive_frequency(oscillator: &Oscillator) -> Result<Expr, ResponseError> {
    let time = Symbol::new("t");
    if !oscillator.force.contains(time) {
        return Err(ResponseError::NoDrive);
    }
    let own = [oscillator.coordinate, oscillator.velocity(), time];
    let mut found: Vec<Expr> = Vec::new();
    for term in oscillator.force.terms() {
        // Whether time stands outside of every periodic function.
        let bare = term.fold(|node, children: &[bool]| match node.node() {
            Node::Symbol(name) => Ok::<bool, ResponseError>(*name == time),
            Node::Function(Function::Sin | Function::Cos | Function::Tan, arguments) if node.contains(time) => {
                let frequency = arguments.first().map(|argument| argument.differentiate(time));
                let frequency = frequency.unwrap_or_else(|| Ok(Expr::zero()))?.expand()?;
                if own.iter().any(|name| frequency.contains(*name)) {
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
    for frequency in &found {
        let ratio = Expr::divide(frequency, &first)?.expand()?;
        let Some(ratio) = ratio.as_number().filter(|ratio| !ratio.is_zero()) else {
            return Err(ResponseError::TwoFrequencies([
                first.to_string(),
                frequency.to_string(),
            ]));
        };
        let ratio = ratio.abs();
        common = Some(match common {
            None => ratio,
            Some(common) => Rational::new(common.numer().gcd(ratio.numer()), common.denom().lcm(ratio.denom())),
        });
    }
    let factor = common.unwrap_or_else(num_traits::One::one);
    let frequency = Expr::number(factor) * first;
    Ok(if frequency.has_leading_minus() {
        -frequency
    } else {
        frequency
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frequency(text: &str) -> Result<String, String> {
        let oscillator = Oscillator::parse(text).unwrap();
        let found = drive_frequency(&oscillator);
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
        ] {
            let refused = frequency(text).unwrap_err();
            assert!(refused.contains(words), "{text}: {refused}");
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

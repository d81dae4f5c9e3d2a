//! Motions of a driven equation by Taylor series, with their variations.
//!
//! ```text
//! in time:      x' = v,                v' = -f(x, v, t; p)                      as the equation was given
//! in phase:     dx/dtheta = v/omega,   dv/dtheta = -f(x, v, theta/omega; p)/omega,   theta = 0 to 2 pi
//! ```
//!
//! In phase a period has one length whatever the parameter is, so that the derivative of its map by
//! the parameter is one more variation. Roots that begin at a corner, as in Hertz's contact, are
//! followed in a variable in which they are power series, so that the number of steps does not
//! depend on the stiffness. In: the right sides. Out: solvers of the motion, and the map of a period
//! with its derivatives.
//!
//! A step to order p costs some p^2 operations for each product of the right sides and of their
//! variations; a period takes 6 to 40 steps.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::driven::Driven;
use super::stability::ORBIT_SAMPLES;
use crate::expr::{Expr, Function, Node};
use crate::numeric::harmonics::Transform;
use crate::numeric::orbit_branch::PeriodImage;
use crate::oscillator::Oscillator;
use crate::symbol::Symbol;
use crate::system::{Event, Path, PathEnd, Solver, System, SystemOptions, Variations};

/// Relative error of a step, below any that a judge asks for.
pub(super) const TOLERANCE: f64 = 1e-13;

/// Relative error of a step of a simulation that is to settle, below the distance at which it has.
pub(super) const SETTLING_TOLERANCE: f64 = 1e-8;

/// A value of the parameter with which nothing cancels; every motion has its own.
pub(super) const ANY: f64 = 0.618_034;

/// Prepares the Taylor series in time of a motion, or of the motion with its variations, to a tolerance;
/// `None` if it has none.
pub(super) fn solver_in_time(
    oscillator: &Oscillator,
    parameter: Symbol,
    varied: bool,
    tolerance: f64,
) -> Option<Solver> {
    let states = [oscillator.coordinate, oscillator.velocity()];
    let right = [Expr::from(states[1]), -&oscillator.force];
    let time = Symbol::new("t");
    let Variations { states, right } = match varied {
        true => {
            let taken: Vec<Symbol> = oscillator.names().into_iter().chain([time]).collect();
            Variations::new(&states, &right, None, &taken).ok()?
        }
        false => Variations { states: states.to_vec(), right: right.to_vec() },
    };
    solver_until(&states, time, &right, (parameter, ANY), (tolerance, &[]))
}

/// Prepares the Taylor series in time of a motion that ends where its velocity falls through zero;
/// `None` if it has none.
pub(super) fn swing_solver(oscillator: &Oscillator, parameter: (Symbol, f64)) -> Option<Solver> {
    let states = [oscillator.coordinate, oscillator.velocity()];
    let right = [Expr::from(states[1]), -&oscillator.force];
    let turns = Event::stop(Expr::from(states[1])).falling();
    solver_until(&states, Symbol::new("t"), &right, parameter, (TOLERANCE, &[turns]))
}

/// Prepares the Taylor series of a system with a parameter.
fn solver(
    states: &[Symbol],
    time: Symbol,
    right: &[Expr],
    parameter: (Symbol, f64),
) -> Option<Solver> {
    solver_until(states, time, right, parameter, (TOLERANCE, &[]))
}

/// Prepares the Taylor series of a system with a parameter, to a tolerance and with events.
fn solver_until(
    states: &[Symbol],
    time: Symbol,
    right: &[Expr],
    parameter: (Symbol, f64),
    (tolerance, events): (f64, &[Event]),
) -> Option<Solver> {
    const STEPS: usize = 4_000;
    let system = System::new(states, time, right, &[parameter].into()).ok()?;
    let options = SystemOptions { tolerance, step_limit: STEPS, ..SystemOptions::default() };
    Some(system.solver(events, &options))
}

/// The first-order equations of a motion in its phase.
#[derive(Clone, Debug)]
pub(super) struct PhaseEquations {
    /// The positions, then the velocities.
    pub(super) states: Vec<Symbol>,
    /// The name of the phase.
    pub(super) phase: Symbol,
    /// The right sides.
    pub(super) right: Vec<Expr>,
}

impl PhaseEquations {
    /// Whether the force may jump at a phase that depends on the parameter or on the motion, so
    /// that variations jump as well.
    fn jump_at_variable_phase(&self, parameter: Symbol) -> bool {
        let nodes = self.right.iter().flat_map(Expr::unique_nodes);
        nodes.into_iter().any(|node| match node.node() {
            Node::Function(Function::Sign | Function::Step, _) => {
                let moves = self.states.iter().chain([&parameter]);
                node.contains(self.phase) && moves.into_iter().any(|name| node.contains(*name))
            }
            _ => false,
        })
    }
}

/// The map of a period by Taylor series in the phase, with its derivatives by the start and by the
/// parameter.
#[derive(Clone, Debug)]
pub(super) struct PeriodSeries {
    phase: Symbol,
    parameter: Symbol,
    varied: Variations,
    solver: Solver,
    /// The transform of the samples of an orbit.
    pub(super) transform: Transform,
}

impl PeriodSeries {
    /// Prepares the map of an equation without jumps; `None` if it has no series.
    pub(super) fn new(driven: &Driven) -> Option<Self> {
        let (equations, parameter) = (&driven.in_phase, driven.parameter);
        if equations.jump_at_variable_phase(parameter) {
            return None;
        }
        let PhaseEquations { states, phase, right } = equations;
        let varied = Variations::new(states, right, Some(parameter), &[*phase]).ok()?;
        let solver = solver(&varied.states, *phase, &varied.right, (parameter, ANY))?;
        let transform = Transform::new(ORBIT_SAMPLES);
        Some(Self { phase: *phase, parameter, varied, solver, transform })
    }

    /// The motion over a period from a start; `None` if it cannot be followed all the way. The path
    /// is in the phase, its states are those of the motion, then its variations.
    pub(super) fn period(&self, start: &DVector<f64>, parameter: f64) -> Option<PeriodImage<Path>> {
        let numbers = (self.parameter, parameter);
        // A parameter in a corner determines where the corner is, and has its own recurrences.
        let own = self
            .solver
            .with_numbers(&[numbers].into())
            .or_else(|| solver(&self.varied.states, self.phase, &self.varied.right, numbers))?;
        let begin = Variations::start(start.as_slice(), true);
        let path = own.solve([0.0, TAU], &begin).ok()?;
        if path.reason() != PathEnd::Reached {
            return None;
        }
        let end = path.states_at(TAU)?;
        let states = start.len();
        let (end, variations) = end.split_at(states);
        let (by_start, by_parameter) = variations.split_at(states * states);
        Some(PeriodImage {
            end: DVector::from_column_slice(end),
            by_start: DMatrix::from_column_slice(states, states, by_start),
            by_parameter: DVector::from_column_slice(by_parameter),
            path,
        })
    }
}

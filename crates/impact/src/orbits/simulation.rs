//! Motions between walls by integration of the equation as it was given, impact by impact.
//!
//! The truth beside the closed forms: it evaluates the original force and the original gaps, locates
//! each impact as an event, and restarts with `gap' -> -e gap'`. It uses no formula of `orbits`.

use crate::Oscillator;
use crate::expr::{CompiledFunctions, Expr};
use crate::symbol::Symbol;
use crate::system::{Event, PathEnd, Solver, System, SystemOptions};
use crate::values::Values;
use crate::wall::Wall;

use super::error::OrbitError;

/// An equation with walls, ready to be followed.
pub struct WalledSimulation {
    solver: Solver,
    walls: Vec<SimulatedWall>,
}

struct SimulatedWall {
    /// Gap, its slope in the coordinate, its slope in time, of coordinate and time.
    gap: CompiledFunctions<3>,
    restitution: f64,
}

/// A motion that was followed.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedMotion {
    /// Time, index of the wall and speed relative to it just before, of each impact.
    pub impacts: Vec<(f64, usize, f64)>,
    /// Position and velocity at the end.
    pub end: [f64; 2],
}

impl WalledSimulation {
    /// Prepares the equation at these values of all its parameters.
    ///
    /// # Errors
    /// A name without a value, a restitution out of range, an equation that cannot be integrated.
    pub fn new(
        oscillator: &Oscillator,
        walls: &[Wall],
        values: &Values,
    ) -> Result<Self, OrbitError> {
        let (x, velocity, t) = (oscillator.coordinate, oscillator.velocity(), Symbol::new("t"));
        let numbers = values.numbers();
        let right = [Expr::from(velocity), -&oscillator.force];
        let system = System::new(&[x, velocity], t, &right, &numbers)?;
        // A motion that leaves a wall may begin a rounding below zero: only falls count.
        let events: Vec<Event> =
            walls.iter().map(|wall| Event::stop(wall.gap.clone()).falling()).collect();
        let exact = values.iter().map(|(name, value)| (name, value.clone())).collect();
        let walls = walls.iter().map(|wall| {
            let gap = wall.gap.substitute_all(&exact)?;
            let slopes = [gap.differentiate(x)?, gap.differentiate(t)?];
            Ok(SimulatedWall {
                gap: CompiledFunctions::new([&gap, &slopes[0], &slopes[1]], &[x, t])?,
                restitution: wall.restitution_at(&numbers)?,
            })
        });
        let walls: Result<Vec<_>, OrbitError> = walls.collect();
        Ok(Self { solver: system.solver(&events, &SystemOptions::default()), walls: walls? })
    }

    /// Follows a motion from a time and a state. Returns `None` if it does not reach the end: it
    /// has more than 20 000 impacts, as one that comes to rest on a wall has, rests on a wall, or overflows.
    pub fn follow(&self, [start, end]: [f64; 2], state: [f64; 2]) -> Option<SimulatedMotion> {
        const MOST_IMPACTS: usize = 20_000;
        let (mut time, mut state) = (start, state);
        let mut impacts: Vec<(f64, usize, f64)> = Vec::new();
        while impacts.len() < MOST_IMPACTS {
            let path = self.solver.solve([time, end], &state).ok()?;
            state = <[f64; 2]>::try_from(path.states_at(path.end())?).ok()?;
            match path.reason() {
                PathEnd::Reached => return Some(SimulatedMotion { impacts, end: state }),
                PathEnd::Event(wall) => {
                    let own = &self.walls[wall];
                    let [_, slope, rate] = own.gap.call(&[state[0], path.end()]);
                    let gap_rate = slope * state[1] + rate;
                    // An impact without speed leaves the motion where it is: it rests on the wall.
                    if gap_rate.is_nan() || gap_rate >= 0.0 || path.end() <= time {
                        return None;
                    }
                    state[1] -= (1.0 + own.restitution) * gap_rate / slope;
                    time = path.end();
                    impacts.push((time, wall, -gap_rate));
                }
                _ => return None,
            }
        }
        None
    }
}

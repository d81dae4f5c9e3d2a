//! The equations of the impacts of a periodic orbit and their derivative, in balls.
//!
//! With the phase `phi = omega t` for time, `c/omega` and `k/omega^2` for damping and stiffness, the gap
//! of a wall is
//!
//! ```text
//! y = s x + w(phi) >= 0,   y'' + c y' + k y = p + a cos(phi) + b sin(phi)
//! y = W(phi) + z,   W = U cos(phi) + V sin(phi),   z'' + c z' + k z = p
//! ```
//!
//! The unknowns are phase and speed of each impact, `phi_i` and `v_i`. From impact i the motion leaves its
//! wall with the speed `e v_i`; at impact j, the next one, the gap of that wall is zero and falls with the
//! speed `v_j`: two equations for each flight, the last of which ends n turns after the first impact.
//! The derivatives are those of the closed form, so that each costs a product with the fundamental matrix.

use num_traits::Zero as _;

use super::flow::{
    LinearFlow, Propagator, State, difference, image, matrix_product, negative, product,
    state_difference, state_sum, sum,
};
use super::{ExactHarmonic, OrbitNotProved, WalledOscillator};
use crate::certificate::fourier_series::WORKING;
use crate::exact::Rational;
use crate::exact::ball::Ball;

/// A constant and a wave of the phase, in balls.
#[derive(Clone, Debug)]
pub(super) struct Harmonic {
    constant: Ball,
    cosine: Ball,
    sine: Ball,
}

impl Harmonic {
    fn new(exact: &ExactHarmonic) -> Self {
        let [constant, cosine, sine] =
            [&exact.constant, &exact.cosine, &exact.sine].map(|own| WORKING.fraction(own));
        Self { constant, cosine, sine }
    }

    /// Value, first and second derivative with respect to the phase.
    pub(super) fn derivatives(&self, angle: &Angle) -> [Ball; 3] {
        let wave = sum(&product(&self.cosine, &angle.cosine), &product(&self.sine, &angle.sine));
        let slope =
            difference(&product(&self.sine, &angle.cosine), &product(&self.cosine, &angle.sine));
        [sum(&self.constant, &wave), slope, negative(&wave)]
    }
}

/// Cosine and sine of a phase.
#[derive(Clone, Debug)]
pub(super) struct Angle {
    cosine: Ball,
    sine: Ball,
}

impl Angle {
    /// The angle of every phase in a ball.
    pub(super) fn new(phase: &Ball) -> Option<Self> {
        let [[cosine, sine], _] = LinearFlow::rotation().over(phase)?.matrix;
        Some(Self { cosine, sine })
    }

    /// The angle that is later by another one.
    pub(super) fn later(&self, by: &Self) -> Self {
        Self {
            cosine: difference(&product(&self.cosine, &by.cosine), &product(&self.sine, &by.sine)),
            sine: sum(&product(&self.sine, &by.cosine), &product(&self.cosine, &by.sine)),
        }
    }
}

/// A wall by its gap.
#[derive(Clone, Debug)]
pub(super) struct GapOfWall {
    /// Whether it bounds the motion from above.
    is_above: bool,
    /// The gap without the coordinate.
    offset: Harmonic,
    /// The force on the gap.
    pub(super) load: Harmonic,
    /// W.
    wave: Harmonic,
    /// e.
    pub(super) restitution: Ball,
    /// Whether e is zero.
    pub(super) is_dead: bool,
}

/// A linear driven oscillator between walls, with the phase of the drive for time.
#[derive(Clone, Debug)]
pub(super) struct GapEquations {
    pub(super) flow: LinearFlow,
    pub(super) walls: Vec<GapOfWall>,
    /// omega.
    frequency: Ball,
}

/// Phase and speed of an impact, known up to radii.
#[derive(Clone, Debug)]
pub(super) struct ImpactBalls {
    pub(super) wall: usize,
    pub(super) phase: Ball,
    /// The speed, in the units of the equation.
    pub(super) speed: Ball,
}

/// The flight from an impact to the next one.
pub(super) struct Flight {
    /// Places of both impacts in the orbit.
    pub(super) ends: [usize; 2],
    /// Its duration, a difference of phases.
    pub(super) duration: Ball,
    /// The motion over it.
    pub(super) propagator: Propagator,
}

/// Residuals of the equations of an orbit and their derivative by phases and speeds in turn.
pub(super) struct Linearised {
    pub(super) residual: Vec<Ball>,
    /// The derivative, by rows.
    pub(super) derivative: Vec<Vec<Ball>>,
}

impl GapEquations {
    /// Writes the equations of the gaps; they are exact until they become balls.
    ///
    /// # Errors
    /// [`OrbitNotProved::Resonance`] where there is no steady wave.
    pub(super) fn new(question: &WalledOscillator) -> Result<Self, OrbitNotProved> {
        let omega = &question.frequency;
        let square = omega * omega;
        let (damping, stiffness) = (&question.damping / omega, &question.stiffness / &square);
        let dynamic = &stiffness - Rational::from_integer(1.into());
        let size = &dynamic * &dynamic + &damping * &damping;
        if size.is_zero() {
            return Err(OrbitNotProved::Resonance);
        }
        let walls = question.walls.iter().map(|wall| {
            // The gap is x less the place of a wall below, and the other way round above.
            let (side, place) = (if wall.is_above { -1 } else { 1 }, &wall.place);
            let side = Rational::from_integer(side.into());
            let offset = place.map(|own| -(own * &side));
            let driven = question.load.map(|own| own * &side / &square);
            let load = ExactHarmonic {
                constant: &driven.constant + &stiffness * &offset.constant,
                cosine: &driven.cosine + &dynamic * &offset.cosine + &damping * &offset.sine,
                sine: &driven.sine + &dynamic * &offset.sine - &damping * &offset.cosine,
            };
            let wave = ExactHarmonic {
                constant: Rational::zero(),
                cosine: (&load.cosine * &dynamic - &load.sine * &damping) / &size,
                sine: (&load.sine * &dynamic + &load.cosine * &damping) / &size,
            };
            GapOfWall {
                is_above: wall.is_above,
                offset: Harmonic::new(&offset),
                load: Harmonic::new(&load),
                wave: Harmonic::new(&wave),
                restitution: WORKING.fraction(&wall.restitution),
                is_dead: wall.restitution.is_zero(),
            }
        });
        Ok(Self {
            walls: walls.collect(),
            flow: LinearFlow {
                damping: WORKING.fraction(&damping),
                stiffness: WORKING.fraction(&stiffness),
            },
            frequency: WORKING.fraction(omega),
        })
    }

    /// A speed as a rate of the phase.
    pub(super) fn by_phase(&self, speed: &Ball) -> Option<Ball> {
        WORKING.quotient(speed, &self.frequency)
    }

    /// The gap of the wall `seen` just after an impact and its rate, and what a later phase and a
    /// larger speed (a rate of the phase) of that impact change.
    fn departure(&self, wall: usize, seen: usize, angle: &Angle, speed: &Ball) -> [State; 3] {
        let own = &self.walls[wall];
        let leaving = product(&own.restitution, speed);
        let zero = Ball::zero;
        if own.is_above == self.walls[seen].is_above {
            return [[zero(), leaving], [zero(), zero()], [zero(), own.restitution.clone()]];
        }
        // The two gaps add up to the distance of the walls.
        let pairs = own.offset.derivatives(angle);
        let others = self.walls[seen].offset.derivatives(angle);
        let [distance, rate, second] = [0, 1, 2].map(|k| sum(&pairs[k], &others[k]));
        [
            [distance, difference(&rate, &leaving)],
            [rate, second],
            [zero(), negative(&own.restitution)],
        ]
    }

    /// The steady wave of a gap and its rate, and their derivatives.
    fn wave(&self, seen: usize, angle: &Angle) -> [State; 2] {
        let [value, slope, second] = self.walls[seen].wave.derivatives(angle);
        [[value, slope.clone()], [slope, second]]
    }

    /// The derivative with respect to time of the free part of a gap.
    fn rate(&self, seen: usize, [position, velocity]: &State) -> State {
        let pull = product(&self.flow.stiffness, position);
        let drag = product(&self.flow.damping, velocity);
        let force = &self.walls[seen].load.constant;
        [velocity.clone(), difference(force, &sum(&pull, &drag))]
    }

    /// The gap of the wall `seen` and its rate at the end of a part of a flight that begins at an
    /// impact with this angle and speed (a rate of the phase).
    pub(super) fn gap(
        &self,
        wall: usize,
        seen: usize,
        [start, end]: [&Angle; 2],
        speed: &Ball,
        part: &Propagator,
    ) -> State {
        let [departure, ..] = self.departure(wall, seen, start, speed);
        let [[from, _], [to, _]] = [self.wave(seen, start), self.wave(seen, end)];
        let free = state_difference(&departure, &from);
        state_sum(&to, &part.advance(&free, &self.walls[seen].load.constant))
    }

    /// The second derivative of the gap of the wall `seen` where it and its rate are these.
    pub(super) fn acceleration(&self, seen: usize, angle: &Angle, gap: &State) -> Ball {
        let [position, velocity] = gap;
        let pull = product(&self.flow.stiffness, position);
        let drag = product(&self.flow.damping, velocity);
        let [load, ..] = self.walls[seen].load.derivatives(angle);
        difference(&load, &sum(&pull, &drag))
    }

    /// The flights of an orbit that lasts `turn`, a multiple of 2 pi.
    ///
    /// # Errors
    /// [`OrbitNotProved::Digits`].
    pub(super) fn flights(
        &self,
        impacts: &[ImpactBalls],
        turn: &Ball,
    ) -> Result<Vec<Flight>, OrbitNotProved> {
        let count = impacts.len();
        let flight = |from: usize| {
            let to = (from + 1) % count;
            let ends = [from, to].map(|own| &impacts[own].phase);
            let mut duration = match count {
                // The phase of the one impact cancels, and with it its radius.
                1 => Ball::zero(),
                _ => difference(ends[1], ends[0]),
            };
            if to == 0 {
                duration = sum(&duration, turn);
            }
            let propagator = self.flow.over(&duration)?;
            Some(Flight { ends: [from, to], duration, propagator })
        };
        (0..count).map(|from| flight(from).ok_or(OrbitNotProved::Digits)).collect()
    }

    /// Residuals and derivative over all phases and speeds in these balls.
    ///
    /// # Errors
    /// [`OrbitNotProved::Digits`].
    pub(super) fn linearised(
        &self,
        impacts: &[ImpactBalls],
        turn: &Ball,
    ) -> Result<Linearised, OrbitNotProved> {
        let size = 2 * impacts.len();
        let digits = || OrbitNotProved::Digits;
        let angles: Option<Vec<Angle>> = impacts.iter().map(|own| Angle::new(&own.phase)).collect();
        let angles = angles.ok_or_else(digits)?;
        let unit = WORKING.quotient(&WORKING.integer(1), &self.frequency).ok_or_else(digits)?;
        let mut residual = Vec::with_capacity(size);
        let mut derivative = vec![vec![Ball::zero(); size]; size];
        for Flight { ends: [from, to], propagator, .. } in self.flights(impacts, turn)? {
            let (wall, seen) = (impacts[from].wall, impacts[to].wall);
            let speeds = [from, to].map(|own| product(&impacts[own].speed, &unit));
            let [departure, by_phase, by_speed] =
                self.departure(wall, seen, &angles[from], &speeds[0]);
            let [left, left_rate] = self.wave(seen, &angles[from]);
            let [right, right_rate] = self.wave(seen, &angles[to]);
            let force = &self.walls[seen].load.constant;
            let free = propagator.advance(&state_difference(&departure, &left), force);
            let later = self.rate(seen, &free);
            let mut missed = state_sum(&right, &free);
            missed[1] = sum(&missed[1], &speeds[1]);
            // A later start shortens the flight, a later end prolongs it.
            let by_start = image(&propagator.matrix, &state_difference(&by_phase, &left_rate));
            let columns = [
                (2 * from, state_difference(&by_start, &later)),
                (2 * to, state_sum(&right_rate, &later)),
                (
                    2 * from + 1,
                    image(&propagator.matrix, &by_speed).map(|own| product(&own, &unit)),
                ),
                (2 * to + 1, [Ball::zero(), unit.clone()]),
            ];
            for (row, residual_of_row) in missed.into_iter().enumerate() {
                residual.push(residual_of_row);
                for (column, state) in &columns {
                    let entry = &mut derivative[2 * from + row][*column];
                    *entry = sum(entry, &state[row]);
                }
            }
        }
        Ok(Linearised { residual, derivative })
    }

    /// The monodromy matrix over an orbit, of the coordinate and its velocity by phase, just after
    /// its first impact.
    ///
    /// # Errors
    /// [`OrbitNotProved::Digits`].
    pub(super) fn monodromy(
        &self,
        impacts: &[ImpactBalls],
        flights: &[Flight],
    ) -> Result<[State; 2], OrbitNotProved> {
        let one = WORKING.integer(1);
        let mut monodromy = [[one.clone(), Ball::zero()], [Ball::zero(), one.clone()]];
        for Flight { ends: [_, to], propagator, .. } in flights {
            let ImpactBalls { wall, phase, speed } = &impacts[*to];
            let own = &self.walls[*wall];
            let saltation =
                Angle::new(phase).zip(self.by_phase(speed)).and_then(|(angle, speed)| {
                    let [force, ..] = own.load.derivatives(&angle);
                    let turned = WORKING.quotient(&force, &speed)?;
                    let kick = product(&sum(&one, &own.restitution), &turned);
                    let back = negative(&own.restitution);
                    Some([[back.clone(), Ball::zero()], [negative(&kick), back]])
                });
            let saltation = saltation.ok_or(OrbitNotProved::Digits)?;
            let leg = matrix_product(&saltation, &propagator.matrix);
            monodromy = matrix_product(&leg, &monodromy);
        }
        Ok(monodromy)
    }
}

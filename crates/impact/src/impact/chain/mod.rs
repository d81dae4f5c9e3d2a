//! The motion of equation (7) without integrating: swing, contact, swing, each in closed form,
//! until it rests.
//!
//! Reference: N. N. Bogoliubov and Y. A. Mitropolsky, *Asymptotic Methods in the Theory of
//! Non-linear Oscillations*, 1961, chapter 1, for the slowly decaying amplitude; `swing` and
//! `bounce` beside this file for the two kinds of phase.
//!
//! ```text
//! S(E) = 2 int x' dx over a stretch of the undamped swing,  T(E) = dS/dE the time of it
//! S -> S exp(-2 zeta T)                                   viscous damping: the action
//! cos a' - cos a = alpha (a + a')                         Coulomb friction from one turning point to the next, exact
//! E_before = E + alpha l + (S/T)(exp(2 zeta T) - 1)       both, over a stretch of length l, with S and T at its reference energy E:
//! E_after  = E - alpha l - (S/T)(1 - exp(-2 zeta T))      that of the turning point, or of its middle
//! ```
//!
//! Before and after a reference energy the stretches mirror each other. Damping of the opposite
//! sign runs the motion backwards, so errors of even order cancel: the error of one swing is of the
//! third power of zeta T.
//!
//! In: a model, a start, settings. Out: a [`Simulation`] like any other, whose pieces are
//! [`ClosedForm`]s. Where the pendulum leans on a barrier, goes deep into a soft one, or sticks on
//! its way, no closed form exists: from there on the motion is integrated, and the result says so.

mod bounce;
mod cycle;
mod leg;
mod swing;

use thiserror::Error;

use super::model::{Friction, Model, Side, Start};
use super::simulation::{
    ClosedForm, ContactRecord, Integrator, REST_FRACTION, Regime, Settings, Simulation,
    SimulationPath, SimulationStop, TurningPoint, first_swing, has_rested,
};
use super::taylor;
use crate::decimal::decimal;
use bounce::ChainBarrier;
pub(super) use bounce::{Bounce, Contacts};
use cycle::{Cycle, CycleStart, LANES, cycles};
use leg::{Leg, leg, rub_lag};
use swing::{SwingAngle, UndampedSwing};

/// The reason why a motion has no chain of closed forms.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum ChainError {
    /// A moving pivot.
    #[error("the chain has no moving pivot: beta = {0} needs the simulation, leave out --chain")]
    Driven(f64),
    /// The arctangent law.
    #[error(
        "the chain takes dry friction by Coulomb's law: write friction = \"exact\", or leave out --chain"
    )]
    Arctangent,
    /// The damping is too strong for a slowly decaying swing.
    #[error(
        "zeta = {0} is too much for a swing that decays slowly: below {MOST_DAMPING} the chain holds, leave out --chain"
    )]
    Overdamped(f64),
    /// The pendulum turns over the top.
    #[error(
        "the pendulum turns over with an energy of {} m g L: the chain is for swings, below 2 m g L; leave out --chain",
        decimal(*.0)
    )]
    TurnsOver(f64),
    /// The motion starts at the upright position or beyond it.
    #[error(
        "the motion starts at x = {0}, not below the upright position: the chain begins with a swing, leave out --chain"
    )]
    Upright(f64),
    /// The dashpot of a main mass is too strong for a slowly decaying swing.
    #[error(
        "the dashpot of the main mass is {} of the critical one: below {MOST_DAMPING} the chain holds, leave out --chain",
        decimal(*.0)
    )]
    OverdampedMainMass(f64),
    /// The two modes of pendulum and main mass are one.
    #[error(
        "the two modes of pendulum and main mass coincide, so that the motion is no sum of two decaying waves: leave out --chain"
    )]
    EqualModes,
    /// The motion starts inside a barrier.
    #[error("the motion starts inside the {} barrier: the chain begins with a swing, leave out --chain", .0.name())]
    Inside(Side),
}

/// The greatest zeta of a chain: beyond it a swing loses most of its energy.
pub const MOST_DAMPING: f64 = 0.5;

/// The motion from this start by closed forms.
///
/// The accuracy of the settings counts only where a part has to be integrated. Cost: a few elliptic
/// integrals a swing.
///
/// # Errors
/// [`ChainError`]: a pivot that moves, friction by the arctangent, a pendulum that turns over,
/// heavy damping, a start in a barrier.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{Integrator, Model, Settings, Start, chain, simulate};
///
/// let model = Model { zeta: 0.02, gamma: 1e6, mu: 1e5, ..Model::default() };
/// let settings = Settings { duration: 250.0, stop_at_rest: true, ..Settings::default() };
/// let (formulas, truth) = (
///     chain(&model, Start::default(), &settings)?,
///     simulate(&model, Start::default(), Integrator::Taylor, &settings)?,
/// );
/// assert!((formulas.rest().time? / truth.rest().time? - 1.0).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn chain(model: &Model, start: Start, settings: &Settings) -> Result<Simulation, ChainError> {
    let mut found = Err(ChainError::Upright(start.x));
    chains(std::iter::once((0, (*model, start))), settings, &mut |_, motion| found = motion);
    found
}

/// [`chain`] for many motions, several side by side; each is passed on with its number as it ends,
/// bit for bit as alone.
pub(super) fn chains(
    mut waiting: impl Iterator<Item = (usize, (Model, Start))>,
    settings: &Settings,
    done: &mut dyn FnMut(usize, Result<Simulation, ChainError>),
) {
    // Each of them stands at the start of a cycle.
    let mut active: Vec<(usize, Chain)> = Vec::with_capacity(LANES);
    loop {
        while active.len() < LANES
            && let Some((number, (model, start))) = waiting.next()
        {
            match Chain::new(&model, start, settings) {
                Ok(mut chain) => match chain.reaches_cycle() {
                    true => active.push((number, chain)),
                    false => done(number, Ok(chain.finish())),
                },
                Err(error) => done(number, Err(error)),
            }
        }
        if active.is_empty() {
            break;
        }
        let start = |lane: usize| active.get(lane).and_then(|(_, chain)| chain.cycle_start());
        let found = cycles(&std::array::from_fn(start));
        for ((_, chain), cycle) in active.iter_mut().zip(found) {
            chain.follow_cycle(cycle);
        }
        // A motion does not depend on its lane: the last takes the place of one that ends.
        for lane in (0..active.len()).rev() {
            if !active[lane].1.reaches_cycle() {
                let (number, mut chain) = active.swap_remove(lane);
                done(number, Ok(chain.finish()));
            }
        }
    }
}

/// The state at the start of the next stretch.
#[derive(Debug, Clone, Copy)]
enum StretchStart {
    /// Rest on this side at this angle.
    Turn(Side, SwingAngle),
    /// Passage of this angle, counted towards this side, with this energy.
    Leaving(Side, SwingAngle, f64),
}

/// The stretches whose energies are similar from one swing to the next: those that leave a barrier,
/// and free ones.
#[derive(Debug, Clone, Copy)]
enum StretchKind {
    FromPlace,
    FromTurn,
}

/// The ratio of the reference energies of the last two stretches of a kind, and its change, from
/// which the next one is estimated.
#[derive(Debug, Clone, Copy)]
struct EnergyRatio {
    ratio: f64,
    change: f64,
    guessed: bool,
}

struct Chain {
    model: Model,
    start: Start,
    settings: Settings,
    barriers: [Option<ChainBarrier>; 2],
    t: f64,
    /// x and x' now.
    state: [f64; 2],
    place: StretchStart,
    count: usize,
    remembered: [EnergyRatio; 2],
    impacts: Vec<ContactRecord>,
    turns: Vec<TurningPoint>,
    path: SimulationPath,
    stop: Option<SimulationStop>,
    /// A tenth of the amplitude of the first swing.
    level: f64,
    /// The part of the motion that is integrated, from now on.
    integrated: Option<Box<Simulation>>,
}

impl Chain {
    /// A motion at its start.
    ///
    /// # Errors
    /// As [`chain`].
    fn new(model: &Model, start: Start, settings: &Settings) -> Result<Self, ChainError> {
        if model.beta != 0.0 {
            return Err(ChainError::Driven(model.beta));
        }
        if model.friction == Friction::Arctangent && model.alpha > 0.0 {
            return Err(ChainError::Arctangent);
        }
        if model.zeta >= MOST_DAMPING {
            return Err(ChainError::Overdamped(model.zeta));
        }
        let energy = model.swing_energy(start.x, start.velocity);
        if start.x.abs() >= std::f64::consts::PI {
            return Err(ChainError::Upright(start.x));
        }
        if energy >= 2.0 {
            return Err(ChainError::TurnsOver(energy));
        }
        if let Some((side, _)) = model.depth(start.x) {
            return Err(ChainError::Inside(side));
        }
        let guess = EnergyRatio { ratio: (-3.0 * model.zeta).exp(), change: 0.0, guessed: true };
        let to = if start.velocity > 0.0 { Side::Right } else { Side::Left };
        let spot = SwingAngle::new(to.sign() * start.x);
        let mut chain = Self {
            model: *model,
            start,
            settings: *settings,
            barriers: [Side::Left, Side::Right].map(|side| ChainBarrier::from_model(model, side)),
            t: 0.0,
            state: [start.x, start.velocity],
            place: StretchStart::Leaving(to, spot, energy),
            count: 0,
            remembered: [guess; 2],
            impacts: Vec::with_capacity(MANY),
            turns: Vec::with_capacity(2 * MANY),
            path: SimulationPath::new(),
            stop: None,
            level: REST_FRACTION * first_swing(model, start),
            integrated: None,
        };
        chain.begin(to, spot);
        Ok(chain)
    }

    /// Sets the place at which the motion begins.
    fn begin(&mut self, to: Side, spot: SwingAngle) {
        let Start { x, velocity } = self.start;
        let next = if velocity == 0.0 {
            self.turns.push(TurningPoint { t: 0.0, x });
            if x == 0.0 || self.sticks(x) {
                return self.hold_at_rest(x);
            }
            let side = if x > 0.0 { Side::Right } else { Side::Left };
            Some(StretchStart::Turn(side, SwingAngle::new(x.abs())))
        } else {
            let touched = self.barrier(to).filter(|barrier| barrier.spot == spot).copied();
            touched.and_then(|barrier| {
                self.contact(&barrier, velocity.abs(), barrier.bounce(velocity.abs()))
            })
        };
        self.place = next.unwrap_or(self.place);
    }

    /// Goes on until the motion leaves a barrier from which it swings back to it; returns whether it
    /// does before it ends.
    fn reaches_cycle(&mut self) -> bool {
        while self.may_go_on() {
            if self.cycle_start().is_some() {
                return true;
            }
            let next = match self.place {
                StretchStart::Turn(side, turn) => self.after_turn(side, turn),
                StretchStart::Leaving(to, spot, energy) => self.after_leaving(to, spot, energy),
            };
            self.place = next.unwrap_or(self.place);
        }
        false
    }

    /// Counts a stretch; returns whether the motion goes on.
    fn may_go_on(&mut self) -> bool {
        if self.stop.is_some() {
            return false;
        }
        self.count += 1;
        if self.count > self.settings.maximum_steps {
            self.stop = Some(SimulationStop::Steps { t: self.t });
        } else if self.settings.interrupt.is_requested() {
            self.stop = Some(SimulationStop::Interrupted { t: self.t });
        } else if self.t >= self.settings.duration {
            self.stop = Some(SimulationStop::Duration);
        }
        self.stop.is_none()
    }

    /// The cycle that begins here; `None` if the motion does not leave a barrier, or reaches another.
    fn cycle_start(&self) -> Option<CycleStart<'_>> {
        let StretchStart::Leaving(to, spot, energy) = self.place else { return None };
        let barrier = self.barrier(to.opposite()).filter(|own| own.spot == spot.mirrored())?;
        if self.barrier(to).is_some_and(|ahead| energy > ahead.spot.energy) {
            return None;
        }
        let last = self.remembered[StretchKind::FromPlace as usize];
        Some(CycleStart { barrier, energy, reference: energy * (last.ratio + last.change) })
    }

    /// Follows the swing from a barrier and back, and the contact there.
    fn follow_cycle(&mut self, cycle: Option<Cycle>) {
        let StretchStart::Leaving(to, spot, energy) = self.place else { return };
        let Some(cycle) = cycle else {
            self.integrate();
            return;
        };
        self.remember(StretchKind::FromPlace, cycle.reference / energy);
        let turn = SwingAngle::at_turn(cycle.turn, cycle.reference);
        let beyond = |ahead: &ChainBarrier| turn.x > ahead.spot.x;
        if self.barrier(to).is_some_and(beyond) || turn.x < spot.x {
            self.integrate();
            return;
        }
        let [out, back] = cycle.times;
        self.swing([energy, turn.energy], out, to, [spot.x, turn.x]);
        let Some(place) = self.rest_at_turning_point(to, turn) else { return };
        self.place = place;
        if !self.may_go_on() {
            return;
        }
        let from = to.opposite();
        let Some(barrier) = self.barrier(from).copied() else { return };
        let next = if turn.energy > barrier.spot.energy && cycle.arrived > barrier.spot.energy {
            self.swing([turn.energy, cycle.arrived], back, from, [-turn.x, barrier.spot.x]);
            self.contact(
                &barrier,
                (2.0 * (cycle.arrived - barrier.spot.energy)).sqrt(),
                cycle.bounce,
            )
        } else {
            self.free(to, turn)
        };
        self.place = next.unwrap_or(self.place);
    }

    /// Remembers the ratio of the last two reference energies of a kind of stretch.
    fn remember(&mut self, kind: StretchKind, ratio: f64) {
        let last = &mut self.remembered[kind as usize];
        let change = if last.guessed { 0.0 } else { ratio - last.ratio };
        *last = EnergyRatio { ratio, change, guessed: false };
    }

    fn barrier(&self, side: Side) -> Option<&ChainBarrier> {
        match side {
            Side::Left => self.barriers[0].as_ref(),
            Side::Right => self.barriers[1].as_ref(),
        }
    }

    /// Whether dry friction holds the pendulum at rest at this angle.
    fn sticks(&self, x: f64) -> bool {
        self.model.alpha > 0.0 && x.sin().abs() <= self.model.alpha
    }

    /// E_before - E of a leg, and its derivative with respect to E.
    fn above(&self, leg: &Leg, swing: &UndampedSwing) -> (f64, f64) {
        let Model { zeta, alpha, .. } = self.model;
        let growth = (2.0 * zeta * (leg.time - leg.lag)).exp_m1();
        let loss = leg.area / leg.time * growth;
        match alpha == 0.0 || leg.length == 0.0 {
            true => (loss, growth),
            false => {
                (loss + alpha * leg.length, growth + alpha / SwingAngle::turn(swing.energy).x.sin())
            }
        }
    }

    /// E - E_after of a leg.
    fn below(&self, leg: &Leg) -> f64 {
        self.model.alpha * leg.length
            - leg.area / leg.time * (-2.0 * self.model.zeta * (leg.time + leg.lag)).exp_m1()
    }

    /// The swing from whose reference energy this leg, run backwards, leads to this energy; `None`
    /// if there is none.
    fn reference(
        &mut self,
        energy: f64,
        kind: StretchKind,
        leg: impl Fn(&UndampedSwing) -> Leg,
    ) -> Option<(UndampedSwing, Leg)> {
        if self.model.zeta == 0.0 && self.model.alpha == 0.0 {
            let swing = UndampedSwing::new(energy);
            return Some((swing, leg(&swing))).filter(|(_, leg)| leg.time > 0.0);
        }
        let last = self.remembered[kind as usize];
        let mut reference = energy * (last.ratio + last.change);
        for _ in 0..MOST_NEWTON {
            let mut swing = UndampedSwing::new(reference);
            let mut leg = leg(&swing);
            if !is_positive(leg.time) {
                return None;
            }
            let (loss, growth) = self.above(&leg, &swing);
            let error = reference + loss - energy;
            let step = error / (1.0 + growth);
            reference -= step;
            if !is_positive(reference) {
                return None;
            }
            if error.abs() <= NEAR * energy {
                // The derivative of an area with respect to the energy is the time; the neglected
                // terms are of second order.
                swing.energy = reference;
                swing.quarter.area -= swing.quarter.time * step;
                leg.area -= leg.time * step;
                self.remember(kind, reference / energy);
                return Some((swing, leg));
            }
        }
        None
    }

    /// Continues from a turning point to the barrier ahead, or to the next turning point.
    fn after_turn(&mut self, side: Side, turn: SwingAngle) -> Option<StretchStart> {
        let (to, energy) = (side.opposite(), turn.energy);
        if let Some(ahead) = self.barrier(to).copied()
            && (ahead.spot.x < 0.0 || energy > ahead.spot.energy)
        {
            let swing = UndampedSwing::new(energy);
            let leg = leg(&self.model, &swing, &ahead.spot, swing.stretch_to(&ahead.spot));
            if !is_positive(leg.time) {
                // The pendulum rests on the barrier and is pressed into it.
                return self.integrate();
            }
            let arrived = energy - self.below(&leg);
            if arrived > ahead.spot.energy {
                let lag =
                    leg.lag - leg.rubbed + rub_lag(self.model.alpha, &ahead.spot, arrived, 1.0);
                let time = leg.time + lag + leg.later(&swing, &ahead.spot, arrived);
                self.swing([energy, arrived], time, to, [-turn.x, ahead.spot.x]);
                let speed = (2.0 * (arrived - ahead.spot.energy)).sqrt();
                return self.contact(&ahead, speed, ahead.bounce(speed));
            }
        }
        self.free(side, turn)
    }

    /// Continues from one turning point to the next, or the next two, if no barrier is in reach.
    fn free(&mut self, side: Side, from: SwingAngle) -> Option<StretchStart> {
        let out_of_reach =
            |barrier: &ChainBarrier| barrier.spot.x > 0.0 && barrier.spot.energy >= from.energy;
        let turns =
            match self.model.alpha == 0.0 && self.barriers.iter().flatten().all(out_of_reach) {
                true => self.undulate(side, from),
                false => self.next_turn_with_friction(side, from),
            };
        turns.or_else(|| match self.stop {
            Some(_) => None,
            None => self.integrate(),
        })
    }

    /// Two turning points under viscous damping, about the energy of the first; `None` if there is
    /// none.
    fn undulate(&mut self, side: Side, from: SwingAngle) -> Option<StretchStart> {
        let half =
            |swing: &UndampedSwing| Leg::free(2.0 * swing.quarter.time, 2.0 * swing.quarter.area);
        let (swing, leg) = self.reference(from.energy, StretchKind::FromTurn, half)?;
        let energy = swing.energy - self.below(&leg);
        if !is_positive(energy) {
            return None;
        }
        let [first, second] = [swing.energy, energy].map(SwingAngle::turn);
        // The mean energy on the way there is greater, on the way back less: dK/dE = area/(8 m (1 -
        // m)) with E = 2 m.
        let stretched = swing.quarter.area / (swing.energy * (2.0 - swing.energy));
        for (energies, turn, side) in
            [([from, first], first, side.opposite()), ([first, second], second, side)]
        {
            let [before, after] = energies;
            let mean = 0.5 * (before.energy + after.energy);
            let time = leg.time + stretched * (mean - swing.energy);
            self.swing([before.energy, after.energy], time, side, [-before.x, after.x]);
            self.rest_at_turning_point(side, turn)?;
            if self.stop.is_some() {
                return None;
            }
        }
        Some(StretchStart::Turn(side, second))
    }

    /// The next turning point with dry friction: half of the viscous damping before it, half after
    /// it; `None` if there is none.
    fn next_turn_with_friction(&mut self, side: Side, from: SwingAngle) -> Option<StretchStart> {
        let to = side.opposite();
        let quarter = |swing: &UndampedSwing| Leg::free(swing.quarter.time, swing.quarter.area);
        let (before, _) = self.reference(from.energy, StretchKind::FromTurn, quarter)?;
        let angle = match self.model.alpha == 0.0 {
            true => SwingAngle::turn(before.energy).x,
            false => turn_after_friction(SwingAngle::turn(before.energy).x, self.model.alpha),
        };
        if angle <= 0.0 {
            // The pendulum comes to rest before the bottom, where friction holds it.
            return None;
        }
        let after = UndampedSwing::new(SwingAngle::new(angle).energy);
        let mut turn = SwingAngle::turn(after.energy - self.below(&quarter(&after)));
        if let Some(ahead) = self.barrier(to)
            && turn.x > ahead.spot.x
        {
            // The swing does not reach the barrier.
            turn = ahead.spot;
        }
        if !is_positive(turn.energy) {
            return None;
        }
        let time = before.quarter.time + after.quarter.time;
        self.swing([from.energy, turn.energy], time, to, [-from.x, turn.x]);
        self.rest_at_turning_point(to, turn)
    }

    /// Continues from an angle on the way to a side: to the barrier there, or to the turning point.
    fn after_leaving(&mut self, to: Side, spot: SwingAngle, energy: f64) -> Option<StretchStart> {
        let ahead = self.barrier(to).copied();
        if let Some(ahead) = ahead
            && energy > ahead.spot.energy
        {
            let crossing = |swing: &UndampedSwing| {
                let (end, start) = (swing.stretch_to(&ahead.spot), swing.stretch_to(&spot));
                Leg {
                    length: 0.5 * (ahead.spot.x - spot.x),
                    ..Leg::free(0.5 * (end.time - start.time), 0.5 * (end.area - start.area))
                }
            };
            if let Some((swing, leg)) = self.reference(energy, StretchKind::FromPlace, crossing) {
                let arrived = swing.energy - self.below(&leg);
                if arrived > ahead.spot.energy {
                    self.swing([energy, arrived], 2.0 * leg.time, to, [spot.x, ahead.spot.x]);
                    let speed = (2.0 * (arrived - ahead.spot.energy)).sqrt();
                    return self.contact(&ahead, speed, ahead.bounce(speed));
                }
            }
        }
        let back = spot.mirrored();
        let model = self.model;
        let found = self.reference(energy, StretchKind::FromPlace, |swing| {
            leg(&model, swing, &back, swing.stretch_to(&back))
        });
        let Some((swing, leg)) = found else {
            return self.integrate();
        };
        let turn = SwingAngle::turn(swing.energy);
        if ahead.is_some_and(|ahead| turn.x > ahead.spot.x) || turn.x < spot.x {
            return self.integrate();
        }
        let lag = leg.lag - leg.rubbed + rub_lag(model.alpha, &back, energy, -1.0);
        let time = leg.time - lag + leg.later(&swing, &back, energy);
        self.swing([energy, swing.energy], time, to, [spot.x, turn.x]);
        self.rest_at_turning_point(to, turn)
    }

    /// The pendulum rests at this spot for a moment, or for good.
    fn rest_at_turning_point(&mut self, side: Side, turn: SwingAngle) -> Option<StretchStart> {
        if self.stop.is_some() {
            return None;
        }
        let x = side.sign() * turn.x;
        self.turns.push(TurningPoint { t: self.t, x });
        self.state = [x, 0.0];
        if self.sticks(x) {
            self.hold_at_rest(x);
            return None;
        }
        if self.settings.rest_energy.is_some_and(|rest| turn.energy <= rest) {
            self.stop = Some(SimulationStop::RestEnergy);
        } else if self.settings.stop_at_rest && has_rested(&self.model, &self.turns, self.level) {
            self.stop = Some(SimulationStop::AtRest);
        }
        Some(StretchStart::Turn(side, turn))
    }

    /// A contact entered with this speed; it is integrated if it is no bounce.
    fn contact(
        &mut self,
        barrier: &ChainBarrier,
        speed: f64,
        bounce: Option<Bounce>,
    ) -> Option<StretchStart> {
        if self.stop.is_some() {
            return None;
        }
        let ChainBarrier { side, spot, .. } = *barrier;
        let x = side.sign() * spot.x;
        self.state = [x, side.sign() * speed];
        let Some(bounce) = bounce else {
            return self.integrate();
        };
        let mut contact = ContactRecord::touched(side, self.t, speed);
        contact.penetration = bounce.depth;
        let deepest = self.t + 0.5 * bounce.duration;
        if deepest <= self.settings.duration {
            let x = x + side.sign() * bounce.depth;
            self.turns.push(TurningPoint { t: deepest, x });
        }
        self.advance(bounce.duration, Regime::Contact(side), || {
            ClosedForm::contact(
                (side, x),
                [bounce.depth, bounce.duration],
                [speed, bounce.speed_out],
            )
        });
        let away = side.opposite();
        let energy = spot.energy + 0.5 * bounce.speed_out * bounce.speed_out;
        if self.stop.is_none() {
            contact.released(&self.model, self.t, bounce.speed_out);
            self.state = [x, away.sign() * bounce.speed_out];
            if self.settings.rest_energy.is_some_and(|rest| energy <= rest) {
                self.stop = Some(SimulationStop::RestEnergy);
            } else if self.settings.stop_at_rest && has_rested(&self.model, &self.turns, self.level)
            {
                self.stop = Some(SimulationStop::AtRest);
            }
        }
        self.impacts.push(contact);
        Some(StretchStart::Leaving(away, spot.mirrored(), energy))
    }

    /// A stretch of the swing between two energies and two places, towards a side.
    fn swing(&mut self, energies: [f64; 2], time: f64, to: Side, places: [f64; 2]) {
        self.advance(time, Regime::Free, || closed_form_between(energies, time, to, places));
    }

    /// Advances the clock by `time`, or to the end of the duration.
    fn advance(&mut self, time: f64, regime: Regime, form: impl Fn() -> ClosedForm) {
        let (start, end) = (self.t, (self.t + time).min(self.settings.duration));
        if self.settings.keep_path && end > start {
            self.path.push_closed([start, end], regime, form());
        }
        if self.t + time > self.settings.duration {
            self.state = form().phase_point_at(end - start).into();
            self.stop = Some(SimulationStop::Duration);
        }
        self.t = end;
    }

    /// Ends the motion at rest.
    fn hold_at_rest(&mut self, x: f64) {
        let end = self.settings.duration;
        if self.settings.keep_path && end > self.t {
            self.path.push_rest([self.t, end], x);
        }
        if end > self.t && self.model.sticks() {
            self.turns.push(TurningPoint { t: end, x });
        }
        self.t = end;
        self.state = [x, 0.0];
        self.stop = Some(SimulationStop::Duration);
    }

    /// Follows the rest of the motion, which has no closed form, by Taylor series.
    fn integrate(&mut self) -> Option<StretchStart> {
        let left = Settings { duration: self.settings.duration - self.t, ..self.settings };
        let [x, velocity] = self.state;
        let motion = taylor::simulate_one(self.model, Start { x, velocity }, left);
        self.stop = Some(motion.stop.delayed_by(self.t));
        self.integrated = Some(Box::new(motion));
        None
    }

    /// The motion that has ended.
    fn finish(&mut self) -> Simulation {
        let mut end_time = self.t;
        let mut steps = self.count;
        if let Some(motion) = self.integrated.take() {
            let from = self.t;
            let [x, velocity] = [motion.end_x, motion.end_velocity];
            self.state = [x, velocity];
            end_time = from + motion.end_time;
            steps += motion.steps;
            self.turns.extend(
                motion
                    .turns
                    .iter()
                    .filter(|turn| turn.t > 0.0)
                    .map(|turn| TurningPoint { t: from + turn.t, ..*turn }),
            );
            self.impacts.extend(motion.impacts.iter().map(|impact| impact.delayed_by(from)));
            self.path.extend(&motion.path, from);
        }
        let [end_x, end_velocity] = self.state;
        let mut motion = Simulation {
            model: self.model,
            start: self.start,
            settings: self.settings,
            integrator: Integrator::Chain,
            path: std::mem::replace(&mut self.path, SimulationPath::new()),
            impacts: std::mem::take(&mut self.impacts),
            turns: std::mem::take(&mut self.turns),
            end_time,
            end_x,
            end_velocity,
            stop: self.stop.unwrap_or(SimulationStop::Duration),
            steps,
            fall: None,
        };
        motion.fall = taylor::time_of_fall_by_series(&motion);
        motion
    }
}

/// Whether a number is positive and not NaN.
fn is_positive(value: f64) -> bool {
    value > 0.0
}

/// The turning point a' that follows a under friction alone, cos a' - cos a = alpha (a + a'),
/// counted to the other side.
///
/// With h = (a + a')/2: sin((a - a')/2) = alpha h/sin h, which has lost the root a' = -a.
fn turn_after_friction(turn: f64, alpha: f64) -> f64 {
    let mut next = turn - 2.0 * alpha;
    for _ in 0..MOST_NEWTON {
        let half = 0.5 * (turn + next);
        let spread = if half.abs() < 1e-8 { 1.0 } else { half / half.sin() };
        let found = turn - 2.0 * (alpha * spread).min(1.0).asin();
        let change = found - next;
        next = found;
        if change.abs() <= 1e-15 * turn {
            break;
        }
    }
    next
}

/// The area in the phase plane of the undamped swing of this amplitude, rad, and of the same
/// between the barriers, units of m g L/omega.
pub(super) fn actions(model: &Model, amplitude: f64) -> (f64, f64) {
    let swing = UndampedSwing::new(SwingAngle::new(amplitude).energy);
    let reach = |side: Side| match model.barrier(side) {
        Some(x) => swing.stretch_to(&SwingAngle::new(side.sign() * x)).area,
        None => swing.quarter.area,
    };
    (4.0 * swing.quarter.area, 2.0 * (reach(Side::Left) + reach(Side::Right)))
}

/// The closed form of a stretch between two energies and two places, towards a side.
fn closed_form_between(energies: [f64; 2], time: f64, to: Side, places: [f64; 2]) -> ClosedForm {
    let moduli = energies.map(|energy| (0.5 * energy).sqrt());
    let mean = (moduli[0] * moduli[1]).sqrt();
    let parameter = mean * mean;
    let middle = UndampedSwing::new(2.0 * parameter);
    // The time from the bottom, in the swing of mean energy, to the phase that the place has in the
    // swing of its own energy.
    let phase = |energy: f64, place: f64| {
        let (sine, _) = SwingAngle::new(place).phase(energy);
        middle.stretch_to(&SwingAngle::new(2.0 * (mean * sine).clamp(-1.0, 1.0).asin())).time
    };
    let [start, end] = [0, 1].map(|index| phase(energies[index], places[index]));
    ClosedForm::Swing {
        sign: to.sign(),
        modulus: moduli[0],
        rate: (moduli[0] / moduli[1]).ln() / time,
        speed: (end - start) / time,
        phase: start,
        parameter,
    }
}

/// Number of impacts for which memory is reserved.
const MANY: usize = 32;

/// Relative error of the reference energy up to which one more step needs no further elliptic
/// integral.
const NEAR: f64 = 5e-4;

/// Largest number of iterations; a few are enough.
const MOST_NEWTON: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_damping_the_chain_is_the_exact_pendulum() {
        let model = Model { right: None, ..Model::default() };
        let settings = Settings { duration: 40.0, ..Settings::default() };
        for amplitude in [0.01, 1.5, 3.0] {
            let start = Start { x: -amplitude, velocity: 0.0 };
            let formulas = chain(&model, start, &settings).expect("a chain");
            let truth = taylor::simulate_one(model, start, settings);
            let difference = formulas.difference(&truth, 2001);
            assert!(difference.displacement < 1e-9 * amplitude, "{amplitude}: {difference:?}");
            assert!(difference.velocity < 1e-9 * amplitude, "{amplitude}: {difference:?}");
        }
    }

    #[test]
    fn dry_friction_alone_turns_where_the_energy_says() {
        let model = Model { alpha: 0.03, right: None, ..Model::default() };
        let settings = Settings { duration: 120.0, ..Settings::default() };
        let formulas = chain(&model, Start::default(), &settings).expect("a chain");
        let turns: Vec<f64> = formulas.turns.iter().map(|turn| turn.x.abs()).collect();
        for pair in turns.windows(2).take(10) {
            let [before, after] = [pair[0], pair[1]];
            assert!((after.cos() - before.cos() - 0.03 * (before + after)).abs() < 1e-14);
        }
        // Held where the weight is less than the friction, as by the integration, to the end.
        let truth = taylor::simulate_one(model, Start::default(), settings);
        assert!((formulas.end_x - truth.end_x).abs() < 1e-3, "{} {}", formulas.end_x, truth.end_x);
        assert_eq!(formulas.end_velocity, 0.0);
    }

    #[test]
    fn the_pieces_join() {
        let model = Model {
            zeta: 0.03,
            alpha: 0.01,
            gamma: 1e5,
            mu: 2e4,
            left: Some(-0.6),
            ..Model::default()
        };
        let start = Start { x: 0.1, velocity: 1.2 };
        let settings = Settings { duration: 30.0, ..Settings::default() };
        let motion = chain(&model, start, &settings).expect("a chain");
        let pieces = motion.path.pieces();
        assert!(pieces.len() > 10);
        let (x, _) = motion.path.phase_point_at(0.0).expect("the start");
        assert!((x - start.x).abs() < 1e-12);
        for pair in pieces.windows(2) {
            assert_eq!(pair[0].end, pair[1].start);
            let (Some(before), Some(after)) = (pair[0].closed_form(), pair[1].closed_form()) else {
                continue;
            };
            let (left, right) =
                (before.phase_point_at(pair[0].end - pair[0].start).0, after.phase_point_at(0.0).0);
            assert!((left - right).abs() < 1e-8, "{left} {right} at {}", pair[0].end);
        }
    }

    #[test]
    fn what_has_no_chain_says_why() {
        let start = Start::default();
        let refused = |model: Model, start: Start| {
            chain(&model, start, &Settings::default()).unwrap_err().to_string()
        };
        let driven = Model { beta: 0.1, frequency_ratio: 1.0, ..Model::default() };
        assert!(refused(driven, start).contains("beta = 0.1"));
        let arctangent = Model { alpha: 0.1, friction: Friction::Arctangent, ..Model::default() };
        assert!(refused(arctangent, start).contains("exact"));
        let heavy = Model { zeta: 0.7, ..Model::default() };
        assert!(refused(heavy, start).contains("0.7"));
        let over = Start { x: 0.0, velocity: 2.1 };
        assert!(refused(Model::default(), over).contains("turns over"));
        let upright = Start { x: -3.2, velocity: 0.0 };
        assert!(refused(Model::default(), upright).contains("starts at x = -3.2"));
        let inside = Start { x: 0.4, velocity: 0.0 };
        assert!(refused(Model::default(), inside).contains("right barrier"));
    }
}

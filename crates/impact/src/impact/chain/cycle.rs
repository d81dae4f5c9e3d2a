//! From a barrier to the turning point and back to its release, for several motions side by side.
//!
//! ```text
//! E + loss(E) = E_out             the reference energy E, by Newton's steps with 1 + d loss/dE
//! loss = alpha l + (S/T)(exp(2 zeta (T - lag)) - 1),   E_back = E - alpha l - (S/T)(1 - exp(-2 zeta (T + lag)))
//! ```
//!
//! T, S and l are those of the stretch between the barrier and the turning point in the undamped
//! swing of energy E ([`swing`](super::swing)); the contact is that of [`bounce`](super::bounce).
//! Every lane takes the steps that it takes alone, so that a motion does not depend on what is beside
//! it. Cost: an iteration or two, each with four elliptic integrals.

use pulp::{Arch, Simd, WithSimd};

use super::bounce::{Bounce, Bounces, ChainBarrier, Contacts};
use super::leg::rub_lag;
use super::swing::{Stretches, SwingAngle, phases, quarters, stretches};
use super::{MOST_NEWTON, NEAR};
use crate::impact::lanes::{Lanes, Mask};

/// Number of motions side by side: they fill a register of 512 bits, or two or four smaller ones.
pub(super) const LANES: usize = 8;

/// The start of a cycle.
#[derive(Debug, Clone, Copy)]
pub(super) struct CycleStart<'a> {
    /// The barrier that is left.
    pub barrier: &'a ChainBarrier,
    /// The energy after it.
    pub energy: f64,
    /// The estimate of the reference energy.
    pub reference: f64,
}

/// A cycle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cycle {
    /// The reference energy: that at the turning point.
    pub reference: f64,
    /// The angle of the turning point from the bottom.
    pub turn: f64,
    /// The times from the barrier and back to it.
    pub times: [f64; 2],
    /// The energy on the return.
    pub arrived: f64,
    /// The contact then; `None` if it is no bounce, or the motion does not return.
    pub bounce: Option<Bounce>,
}

/// The cycles of up to [`LANES`] motions; `None` where there is no start, or no swing has its energy
/// at the barrier.
pub(super) fn cycles(starts: &[Option<CycleStart>; LANES]) -> [Option<Cycle>; LANES] {
    match starts {
        [Some(only), others @ ..] if others.iter().all(Option::is_none) => {
            let [cycle] = side_by_side::<1>([only]);
            let mut cycles = [None; LANES];
            cycles[0] = cycle;
            cycles
        }
        _ => {
            // Lanes without a motion repeat another.
            let Some(any) = starts.iter().flatten().next() else { return [None; LANES] };
            let cycles = side_by_side(starts.each_ref().map(|start| start.as_ref().unwrap_or(any)));
            std::array::from_fn(|lane| cycles[lane].filter(|_| starts[lane].is_some()))
        }
    }
}

fn side_by_side<const L: usize>(starts: [&CycleStart; L]) -> [Option<Cycle>; L] {
    let gathered = |number: fn(&CycleStart) -> f64| Lanes(starts.map(number));
    let found = Arch::new().dispatch(SideBySide::<L> {
        contacts: &Contacts::of(starts.map(|start| start.barrier)),
        energy: gathered(|start| start.energy),
        reference: gathered(|start| start.reference),
        x: gathered(|start| start.barrier.spot.x),
        half_sine: gathered(|start| start.barrier.spot.half_sine()),
        at_rest: gathered(|start| start.barrier.spot.energy),
    });
    std::array::from_fn(|lane| {
        found.is_found.0[lane].then(|| Cycle {
            reference: found.reference.0[lane],
            turn: found.turn.0[lane],
            times: [found.times[0].0[lane], found.times[1].0[lane]],
            arrived: found.arrived.0[lane],
            bounce: found.bounces.lane(lane),
        })
    })
}

/// The inputs of the cycles.
struct SideBySide<'a, const L: usize> {
    contacts: &'a Contacts<L>,
    energy: Lanes<L>,
    reference: Lanes<L>,
    /// The angles of the barriers, sin(x/2) and 1 - cos x there.
    x: Lanes<L>,
    half_sine: Lanes<L>,
    at_rest: Lanes<L>,
}

/// [`Cycle`]s.
struct Cycles<const L: usize> {
    is_found: Mask<L>,
    reference: Lanes<L>,
    turn: Lanes<L>,
    times: [Lanes<L>; 2],
    arrived: Lanes<L>,
    bounces: Bounces<L>,
}

impl<const L: usize> WithSimd for SideBySide<'_, L> {
    type Output = Cycles<L>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Cycles<L> {
        let (is_found, swing) = self.reference_swings();
        let Contacts { zeta, alpha, .. } = *self.contacts;
        let Legs { energy, time, area, length, lag, rubbed, phase } = swing;
        let turn = turning_points(energy);
        let loss = area / time * (-2.0 * zeta * (time + lag)).exp_m1();
        let arrived = energy - (alpha * length - loss);
        let [mut out, mut back] = [lag - rubbed; 2];
        if alpha.is_above(Lanes::all(0.0)).any() {
            for lane in 0..L {
                let spot = SwingAngle::new(self.x.0[lane]);
                let lag = |energy: f64, direction| rub_lag(alpha.0[lane], &spot, energy, direction);
                out.0[lane] += lag(self.energy.0[lane], -1.0);
                back.0[lane] += lag(arrived.0[lane], 1.0);
            }
        }
        let later = |own: Lanes<L>| later(energy, phase, self.half_sine, own);
        let times = [time - out + later(self.energy), time + back + later(arrived)];
        let speed = (2.0 * (arrived - self.at_rest)).at_least(0.0).sqrt();
        let bounces = self.contacts.bounces(speed);
        Cycles { is_found, reference: energy, turn, times, arrived, bounces }
    }
}

/// The stretches between barriers and turning points.
struct Legs<const L: usize> {
    energy: Lanes<L>,
    time: Lanes<L>,
    area: Lanes<L>,
    length: Lanes<L>,
    lag: Lanes<L>,
    rubbed: Lanes<L>,
    phase: (Lanes<L>, Lanes<L>),
}

impl<const L: usize> SideBySide<'_, L> {
    /// The swings from whose turning points the motions, run backwards, leave the barriers with
    /// these energies, and where there are any.
    #[inline(always)]
    fn reference_swings(&self) -> (Mask<L>, Legs<L>) {
        let Contacts { zeta, alpha, .. } = *self.contacts;
        let zero = Lanes::all(0.0);
        let mut found = Legs {
            energy: self.reference,
            time: zero,
            area: zero,
            length: zero,
            lag: zero,
            rubbed: zero,
            phase: (zero, zero),
        };
        let (mut is_open, mut is_found) = (Mask([true; L]), Mask([false; L]));
        for _ in 0..MOST_NEWTON {
            let energy = found.energy;
            let phase = phases(self.half_sine, energy);
            let (quarter, reach) = (quarters(energy), stretches(energy, phase));
            let Stretches { time, area } =
                Stretches { time: quarter.time + reach.time, area: quarter.area + reach.area };
            let (sine, cosine) = phase;
            let (mut length, mut rubbed, mut rubs) = (zero, zero, zero);
            if alpha.is_above(zero).any() {
                // sin x at the turning point.
                let force = (energy * (2.0 - energy)).at_least(f64::MIN_POSITIVE).sqrt();
                length = turning_points(energy) + self.x;
                rubs = alpha / force;
                rubbed = rubs.at_most(1.0);
            }
            let lag = cosine * (zeta * cosine + rubbed);
            let growth = (2.0 * zeta * (time - lag)).exp_m1();
            let error = energy + (area / time * growth + alpha * length) - self.energy;
            let step = error / (1.0 + (growth + rubs));
            let next = energy - step;
            let swings = time.is_above(zero).and(next.is_above(zero));
            let is_near = error.abs().is_above(NEAR * self.energy).not();
            let is_new = is_open.and(swings).and(is_near);
            // The derivative of an area with respect to the energy is the time; the neglected terms
            // are of second order.
            found = Legs {
                energy: is_open.and(swings).select(next, found.energy),
                time: is_new.select(time, found.time),
                area: is_new.select(area - time * step, found.area),
                length: is_new.select(length, found.length),
                lag: is_new.select(lag, found.lag),
                rubbed: is_new.select(cosine * rubbed, found.rubbed),
                phase: (is_new.select(sine, found.phase.0), is_new.select(cosine, found.phase.1)),
            };
            is_found = is_found.or(is_new);
            is_open = is_open.and(swings).and(is_near.not());
            if !is_open.any() {
                break;
            }
        }
        (is_found, found)
    }
}

/// The angles of the turning points of swings of these energies, from the bottom.
#[inline(always)]
fn turning_points<const L: usize>(energy: Lanes<L>) -> Lanes<L> {
    2.0 * (0.5 * energy).at_least(0.0).sqrt().at_most(1.0).asin()
}

/// Delays of the passage of an angle with other energies, compared with swings of these energies at
/// the given phases.
#[inline(always)]
pub(super) fn later<const L: usize>(
    energy: Lanes<L>,
    (sine, cosine): (Lanes<L>, Lanes<L>),
    half_sine: Lanes<L>,
    own: Lanes<L>,
) -> Lanes<L> {
    let (own_sine, own_cosine) = phases(half_sine, own);
    let change = (own_sine * cosine - own_cosine * sine).at_least(-1.0).at_most(1.0).asin();
    change / (1.0 - 0.5 * energy * sine * sine).sqrt()
}

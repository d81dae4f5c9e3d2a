//! The backbone curve: the true frequency against the amplitude, and the amplitudes at which it may
//! vary on a short scale.

use std::cell::RefCell;
use std::collections::BTreeMap;

use super::orbit::{NumericOscillator, OrbitTarget};
use crate::conservative::is_odd;
use crate::conservative::well::Well;
use crate::numeric::ode::root::find_root;
use crate::oscillator::Oscillator;
use crate::symbol::Symbol;

/// The true frequency as a function of the amplitude, each value computed once.
pub(super) struct TrueBackbone<'a> {
    amplitude: Symbol,
    /// The values of the symbols.
    pub(super) numbers: &'a BTreeMap<Symbol, f64>,
    physics: Option<NumericOscillator>,
    known: RefCell<BTreeMap<u64, Option<f64>>>,
    well: Option<Well>,
    /// Amplitudes at which the motion reaches a corner or a narrow place of the force.
    places: Vec<f64>,
    /// Range of the search in multiples of the given amplitude, for a motion without escape.
    times: f64,
}

/// Range of the search in multiples of the given amplitude, for a motion without escape.
const FARTHEST: f64 = 100.0;

/// That range if each frequency is found by integration: terms in the velocity may grow without
/// bound.
const FARTHEST_BY_STEPS: f64 = 2.0;

/// Evaluations of the force that one true frequency may take, and all of them together: some
/// seconds of work. For a force that oscillates thousands of times along a motion the range is
/// shorter.
const MOST_FOR_ONE: f64 = 3e7;
const MOST: u64 = 100_000_000;

impl<'a> TrueBackbone<'a> {
    /// The backbone of the motions of `meant`, in their well if it has an end.
    pub(super) fn new(
        oscillator: &'a Oscillator,
        meant: &OrbitTarget,
        numbers: &'a BTreeMap<Symbol, f64>,
        well: Option<Well>,
    ) -> Self {
        let mut backbone = Self {
            amplitude: meant.convention.symbol(),
            numbers,
            physics: NumericOscillator::new(oscillator, meant, numbers).ok(),
            known: RefCell::default(),
            well,
            places: vec![],
            times: FARTHEST,
        };
        let asked = backbone.given_amplitude().abs();
        let _ = backbone.frequency(asked);
        let work = backbone.physics.as_ref().map_or(0, |physics| physics.rest.evaluations());
        let by_energy = backbone.physics.as_ref().is_none_or(NumericOscillator::by_energy);
        backbone.times = match by_energy {
            true => (MOST_FOR_ONE / work.max(1) as f64).clamp(1.0, FARTHEST),
            false => FARTHEST_BY_STEPS,
        };
        let at_origin = meant.equilibrium.is_zero();
        let symmetric =
            at_origin && is_odd(&oscillator.force, oscillator.coordinate).unwrap_or(false);
        backbone.places = backbone.reached_places(symmetric).unwrap_or_default();
        backbone
    }

    /// The amplitude asked for, with its sign.
    pub(super) fn given_amplitude(&self) -> f64 {
        self.numbers.get(&self.amplitude).copied().unwrap_or(1.0)
    }

    /// The numbers with another size of the amplitude.
    pub(super) fn numbers_at(&self, size: f64) -> BTreeMap<Symbol, f64> {
        let mut numbers = self.numbers.clone();
        numbers.insert(self.amplitude, size.copysign(self.given_amplitude()));
        numbers
    }

    /// The size of the amplitude beyond which no motion released on the side asked for is periodic.
    pub(super) fn largest_amplitude(&self) -> f64 {
        let end = self.well.and_then(|well| well.on_side(self.given_amplitude()));
        end.map_or(f64::INFINITY, |end| end.amplitude.abs())
    }

    /// The size of the amplitude that periodic motions exceed: zero where they begin at rest.
    pub(super) fn smallest_amplitude(&self) -> f64 {
        self.well.map_or(0.0, |well| well.smallest_amplitude())
    }

    /// Whether the motions run over hilltops beyond the equilibrium, for an oscillating force.
    pub(super) fn has_waves_of_hilltops(&self) -> bool {
        let inner = self.well.and_then(|well| well.inner);
        let rest = self.physics.as_ref().map(|physics| &physics.rest);
        inner
            .zip(rest)
            .is_some_and(|(inner, rest)| inner.place != rest.equilibrium() && rest.waves())
    }

    /// The largest amplitude of the search.
    pub(super) fn search_limit(&self) -> f64 {
        f64::min(0.999 * self.largest_amplitude(), self.times * self.given_amplitude().abs())
            .max(self.given_amplitude().abs().min(self.largest_amplitude()))
    }

    /// The true frequency; `None` if the motion is not periodic.
    pub(super) fn frequency(&self, size: f64) -> Option<f64> {
        if let Some(known) = self.known.borrow().get(&size.to_bits()) {
            return *known;
        }
        let affordable = |physics: &&NumericOscillator| physics.rest.evaluations() < MOST;
        let found = self
            .physics
            .as_ref()
            .filter(affordable)
            .and_then(|physics| physics.frequency(size.copysign(self.given_amplitude())).ok());
        self.known.borrow_mut().insert(size.to_bits(), found);
        found
    }

    /// Sizes of the amplitude at which either turning point stands on a corner or a narrow place.
    /// For a force that oscillates everywhere a selection suffices, because the error between
    /// points is followed by bisection.
    fn reached_places(&self, symmetric: bool) -> Option<Vec<f64>> {
        const MOST_PLACES: usize = 64;
        /// Number of turning points that the search for a root takes.
        const FOR_A_ROOT: u64 = 8;
        let physics = self.physics.as_ref()?;
        let at_once = FOR_A_ROOT * physics.rest.evaluations();
        // These places only guide the search, and may take a quarter of the work.
        let affordable = || physics.rest.evaluations() + at_once < MOST / 4;
        let (side, farthest) = (self.given_amplitude().signum(), self.search_limit());
        let mut sizes: Vec<f64> = Vec::new();
        let cuts = physics.rest.cuts(-farthest, farthest);
        for &place in cuts.iter().step_by(cuts.len().div_ceil(MOST_PLACES).max(1)) {
            let distance = side * place;
            if distance > 0.0 {
                sizes.push(distance);
                continue;
            }
            // The far turning point: by symmetry, or where the energies are equal.
            sizes.push(-distance);
            if symmetric || !affordable() {
                continue;
            }
            let turns = |size: f64| match physics.rest.turning_point(side * size) {
                Ok(end) if affordable() => side * (place - end),
                _ => f64::NAN,
            };
            sizes.extend(find_root(turns, 1e-3 * farthest, 0.999 * farthest).ok());
        }
        sizes.sort_by(f64::total_cmp);
        sizes.dedup();
        Some(sizes.iter().copied().step_by(sizes.len().div_ceil(MOST_PLACES).max(1)).collect())
    }

    /// Sizes of the amplitude from rest to the end of the search, in order.
    pub(super) fn amplitudes(&self) -> Vec<f64> {
        const PER_DECADE: i32 = 4;
        const LINEAR: usize = 8;
        let (asked, farthest) = (self.given_amplitude().abs(), self.search_limit());
        let mut sizes: Vec<f64> = (-2 * PER_DECADE..=2 * PER_DECADE)
            .map(|k| asked * 10.0_f64.powf(f64::from(k) / f64::from(PER_DECADE)))
            .collect();
        sizes.extend((1..=LINEAR).map(|k| farthest * k as f64 / LINEAR as f64));
        sizes.extend((1..=LINEAR).map(|k| asked * k as f64 / LINEAR as f64));
        let inner = self.smallest_amplitude();
        if inner > 0.0 {
            // The frequency falls to zero there, as the inverse of a logarithm.
            let above =
                [1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0];
            sizes.extend(above.map(|part| inner * (1.0 + part)));
            sizes
                .extend((1..LINEAR).map(|k| inner + (farthest - inner) * k as f64 / LINEAR as f64));
        }
        sizes.extend(&self.places);
        sizes.push(asked);
        sizes.retain(|size| *size > inner && *size <= farthest);
        sizes.sort_by(f64::total_cmp);
        sizes.dedup_by(|second, first| {
            *second != asked && *first != asked && *second - *first < 1e-9 * *first
        });
        sizes
    }
}

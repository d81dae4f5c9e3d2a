//! The true motion of an equation as it was typed: its period from the energy or the Runge-Kutta
//! return, its path from Runge-Kutta. The wanted motion is described by plain data
//! ([`OrbitTarget`]). This module does not use the derivation of a formula;
//! `tests/library/layers.rs` checks that.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::VerificationError;
use crate::conservative::force::CentredForce;
use crate::exact::rational::from_f64;
use crate::expr::{CompiledFunction, Expr, ExprError};
use crate::numeric::ode::energy::grows_towards_zero;
use crate::numeric::ode::root::find_root;
use crate::numeric::period::{PeriodError, Swing, period_between, swing_with_cuts};
use crate::numeric::return_map::{AutonomousEquation, NumericalLimitCycle, nearest_limit_cycle};
use crate::oscillator::Oscillator;
use crate::solution::AmplitudeConvention;
use crate::symbol::Symbol;

/// Number of points per period at which motions are compared and from which harmonics are computed.
pub(super) const SAMPLES: usize = 1024;

/// The true motion that an answer is compared with.
pub(super) struct OrbitTarget {
    /// The equilibrium about which it oscillates.
    pub(super) equilibrium: Expr,
    /// The definition of its amplitude.
    pub(super) convention: AmplitudeConvention,
    /// The neighbourhood of a limit cycle; `None` for a member of a family of periodic motions.
    pub(super) limit_cycle: Option<NearCycle>,
    /// Approximate omega if the energy does not give the period; it only limits the time of the
    /// search for the return.
    pub(super) frequency: Option<f64>,
}

/// The neighbourhood in which a limit cycle is searched.
pub(super) struct NearCycle {
    /// Its approximate amplitude.
    pub(super) amplitude: f64,
    /// Whether the cycle attracts, to choose between cycles close to each other; `None` if either
    /// will do.
    pub(super) attracts: Option<bool>,
}

impl OrbitTarget {
    /// The amplitude among the numbers; one if there is none, as for a frequency that does not
    /// depend on it.
    pub(super) fn amplitude_at(&self, numbers: &BTreeMap<Symbol, f64>) -> f64 {
        numbers.get(&self.convention.symbol()).copied().unwrap_or(1.0)
    }
}

/// One period of a true motion, from a turning point.
enum Orbit {
    Swing(Swing),
    LimitCycle(NumericalLimitCycle),
}

impl Orbit {
    fn period(&self) -> f64 {
        match self {
            Self::Swing(path) => path.period(),
            Self::LimitCycle(cycle) => cycle.period(),
        }
    }

    /// Displacement and velocity, `t` between zero and the period.
    fn phase_point_at(&self, t: f64) -> (f64, f64) {
        match self {
            Self::Swing(path) => path.phase_point_at(t).unwrap_or((f64::NAN, f64::NAN)),
            Self::LimitCycle(cycle) => cycle.phase_point_at(t),
        }
    }
}

/// The true periodic motion that a formula approximates.
pub(super) struct TrueMotion {
    /// omega.
    pub(super) frequency: f64,
    /// `None` if the energy gives the period but Runge-Kutta cannot follow the motion.
    orbit: Option<Orbit>,
    /// The instant of the path that is `t = 0` of the formula.
    shift: f64,
    /// The amplitude, a positive length.
    pub(super) amplitude: f64,
}

impl TrueMotion {
    /// The motion described by the target, of the equation as it was typed.
    ///
    /// # Errors
    /// There is none, or it cannot be followed.
    pub(super) fn follow(
        oscillator: &Oscillator,
        meant: &OrbitTarget,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<Self, VerificationError> {
        /// Relative agreement of the periods by Runge-Kutta and by the energy that is required to
        /// use the path.
        const AGREEMENT: f64 = 1e-6;
        let physics = NumericOscillator::new(oscillator, meant, numbers)?;
        if let Some(near) = &meant.limit_cycle {
            let cycle = physics.limit_cycle(near)?;
            let frequency = TAU / cycle.period();
            let orbit = Orbit::LimitCycle(cycle);
            let equilibrium = physics.rest.equilibrium();
            return Ok(Self::from_orbit(meant, numbers, orbit, frequency, equilibrium));
        }
        let start = physics.start(meant.amplitude_at(numbers))?;
        if physics.by_energy() && meant.convention == AmplitudeConvention::Initial {
            // The energy decides first whether there is a periodic orbit, and gives the reason if
            // not.
            let period = physics.period(start);
            let period = period.map_err(|error| physics.rest.why_no_period(start, error))?;
            let path = physics.swing(start, 2.0 * period).ok();
            let path = path.filter(|path| (path.period() / period - 1.0).abs() < AGREEMENT);
            return Ok(Self {
                frequency: TAU / period,
                orbit: path.map(Orbit::Swing),
                shift: 0.0,
                amplitude: start.abs(),
            });
        }
        let path = physics.swing(start, physics.longest)?;
        let frequency = match physics.by_energy() {
            true => TAU / physics.period(start)?,
            false => TAU / path.period(),
        };
        let equilibrium = physics.rest.equilibrium();
        Ok(Self::from_orbit(meant, numbers, Orbit::Swing(path), frequency, equilibrium))
    }

    fn from_orbit(
        meant: &OrbitTarget,
        numbers: &BTreeMap<Symbol, f64>,
        orbit: Orbit,
        frequency: f64,
        equilibrium: f64,
    ) -> Self {
        let shift = match meant.convention {
            AmplitudeConvention::Initial => 0.0,
            AmplitudeConvention::FirstHarmonic => {
                let (cosine, sine) = first_harmonic(&orbit);
                sine.atan2(cosine) / TAU * orbit.period()
            }
        };
        let amplitude = match (meant.convention, &meant.limit_cycle) {
            (AmplitudeConvention::FirstHarmonic, None) => meant.amplitude_at(numbers).abs(),
            _ => (orbit.phase_point_at(0.0).0 - equilibrium).abs(),
        };
        Self { frequency, orbit: Some(orbit), shift, amplitude }
    }

    /// The limit cycle, if the motion is one; `None` otherwise.
    pub(super) fn limit_cycle(&self) -> Option<&NumericalLimitCycle> {
        match &self.orbit {
            Some(Orbit::LimitCycle(cycle)) => Some(cycle),
            _ => None,
        }
    }

    /// The amplitude of this free motion by the other convention: the first harmonic for a release,
    /// the release for a first harmonic; `None` if its path is not known.
    pub(super) fn amplitude_by_the_other(
        &self,
        convention: AmplitudeConvention,
        equilibrium: f64,
    ) -> Option<f64> {
        let orbit = self.orbit.as_ref()?;
        Some(match convention {
            AmplitudeConvention::Initial => first_harmonic(orbit).0,
            AmplitudeConvention::FirstHarmonic => orbit.phase_point_at(0.0).0 - equilibrium,
        })
    }

    /// Whether its path is known, not only its frequency.
    pub(super) fn has_path(&self) -> bool {
        self.orbit.is_some()
    }

    /// The period.
    pub(super) fn period(&self) -> f64 {
        self.orbit.as_ref().map_or(TAU / self.frequency, Orbit::period)
    }

    /// The time, the true position and the true velocity at the time `t` of the formula.
    pub(super) fn sample(&self, t: f64) -> (f64, f64, f64) {
        let place = (t + self.shift).rem_euclid(self.period());
        let (x, v) =
            self.orbit.as_ref().map_or((f64::NAN, f64::NAN), |orbit| orbit.phase_point_at(place));
        (t, x, v)
    }
}

/// The equation with numbers for its parameters, in the distance from its equilibrium.
pub(super) struct NumericOscillator {
    /// The force at rest.
    pub(super) rest: CentredForce,
    /// The velocity-dependent part of the force as a function of position and velocity; `None` if
    /// the period follows from the energy.
    moving: Option<CompiledFunction>,
    /// The longest time for which a motion is followed.
    longest: f64,
    /// The definition of the amplitude.
    convention: AmplitudeConvention,
}

impl NumericOscillator {
    pub(super) fn new(
        oscillator: &Oscillator,
        meant: &OrbitTarget,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<Self, VerificationError> {
        let parts = oscillator.parts()?;
        let amplitude = meant.amplitude_at(numbers);
        let (x, v) = (oscillator.coordinate, oscillator.velocity());
        let (at_rest, moving) = match parts.of_position_alone() {
            true => (oscillator.force.clone(), None),
            false => {
                let velocities = Expr::sum([parts.inertia, parts.damping, parts.forcing]);
                let moving = with_numbers(oscillator, &velocities, numbers)?;
                (parts.restoring, Some(CompiledFunction::new(&moving, &[x, v])?))
            }
        };
        meant.equilibrium.evaluate(numbers)?;
        let rest = CentredForce::new(&at_rest, x, &meant.equilibrium, numbers, amplitude);
        let mut physics = Self {
            rest: rest
                .ok_or_else(|| VerificationError::Missing(without_number(oscillator, numbers)))?,
            moving,
            longest: f64::INFINITY,
            convention: meant.convention,
        };
        // The limit is a thousand periods by the approximate frequency, or by a linear force as
        // strong at the start: a motion that has not turned by then does not oscillate.
        let slowest = match meant.frequency.filter(|_| !physics.by_energy()) {
            Some(frequency) => frequency,
            None => {
                let rate = (physics.force_at(amplitude, 0.0) / amplitude).abs().sqrt();
                if rate.is_normal() { rate } else { 1.0 }
            }
        };
        physics.longest = 1000.0 * TAU / slowest;
        Ok(physics)
    }

    /// Whether the force is infinite at rest, as `1/x` is; `amplitude` is the scale of the motion.
    pub(super) fn is_infinite_at_rest(&self, amplitude: f64) -> bool {
        grows_towards_zero(&|y| self.force_at(y, 0.0), amplitude)
    }

    /// Whether the period follows from the energy.
    pub(super) fn by_energy(&self) -> bool {
        self.moving.is_none()
    }

    /// The force at a distance from the equilibrium and a velocity.
    pub(super) fn force_at(&self, y: f64, v: f64) -> f64 {
        let position = self.rest.equilibrium() + y;
        let moving = self.moving.as_ref().map_or(0.0, |moving| moving.call(&[position, v]));
        self.rest.value(y) + moving
    }

    /// The period of a motion released at this distance from the equilibrium, by its energy.
    pub(super) fn period(&self, start: f64) -> Result<f64, PeriodError> {
        self.rest.between_turning_points(start, |force, end| period_between(force, start, end))
    }

    /// omega of the true motion with this amplitude.
    ///
    /// # Errors
    /// There is none, or it cannot be followed.
    pub(super) fn frequency(&self, amplitude: f64) -> Result<f64, VerificationError> {
        let start = self.start(amplitude)?;
        let period = match self.by_energy() {
            true => self.period(start)?,
            false => self.swing(start, self.longest)?.period(),
        };
        Ok(TAU / period)
    }

    /// One swing by Runge-Kutta, in positions, not in distances from the equilibrium.
    fn swing(&self, start: f64, longest: f64) -> Result<Swing, PeriodError> {
        let end = match self.by_energy() {
            true => self.rest.turning_point(start)?,
            false => -start,
        };
        let acceleration = |_: f64, y: f64, v: f64| -self.force_at(y, v);
        let origin = self.rest.equilibrium();
        let cuts = self.rest.cuts(start, end);
        let swing = swing_with_cuts(&acceleration, &cuts, 0.0, start, longest)?;
        Ok(swing.moved(origin))
    }

    /// The true limit cycle nearest to an amplitude.
    fn limit_cycle(&self, near: &NearCycle) -> Result<NumericalLimitCycle, VerificationError> {
        let amplitude = near.amplitude;
        let equilibrium = self.rest.equilibrium();
        let step = 1e-3 * amplitude;
        let slope = (self.rest.value(step) - self.rest.value(-step)) / (2.0 * step);
        let equation = AutonomousEquation {
            acceleration: &|x, v| -self.force_at(x - equilibrium, v),
            equilibrium,
            amplitude,
            frequency: if slope.sqrt().is_normal() { slope.sqrt() } else { 1.0 },
        };
        Ok(nearest_limit_cycle(&equation, near.attracts)?)
    }

    /// The distance from the equilibrium to start from: given, or found so that the first harmonic
    /// of the true motion has the amplitude asked for.
    pub(super) fn start(&self, amplitude: f64) -> Result<f64, VerificationError> {
        if self.convention == AmplitudeConvention::Initial {
            return Ok(amplitude);
        }
        let excess = |start: f64| {
            let path = self.swing(start, self.longest);
            path.map_or(f64::NAN, |path| first_harmonic(&Orbit::Swing(path)).0 - amplitude)
        };
        let at = |factor: f64| factor * amplitude;
        for spread in [0.05, 0.2, 0.5] {
            if let Ok(start) = find_root(excess, at(1.0 - spread), at(1.0 + spread)) {
                return Ok(start);
            }
        }
        Err(PeriodError::NoReturn(self.longest).into())
    }
}

/// The parameters that have no number.
fn without_number(oscillator: &Oscillator, numbers: &BTreeMap<Symbol, f64>) -> Vec<Symbol> {
    let parameters = oscillator.parameters.iter();
    parameters.filter(|name| !numbers.contains_key(name)).copied().collect()
}

/// An expression with exact numbers in place of the parameters.
fn with_numbers(
    oscillator: &Oscillator,
    expression: &Expr,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Expr, ExprError> {
    let exact = |name: &Symbol| {
        let value = from_f64(*numbers.get(name)?)?;
        Some((*name, Expr::number(value)))
    };
    let values = oscillator.parameters.iter().filter_map(exact).collect();
    expression.substitute_all(&values)
}

/// `(2/T) int x cos, (2/T) int x sin` over one period, by the trapezoidal rule, which is exact to
/// rounding here.
fn first_harmonic(orbit: &Orbit) -> (f64, f64) {
    let period = orbit.period();
    let sample = |k: usize| {
        let phase = k as f64 / SAMPLES as f64;
        let x = orbit.phase_point_at(period * phase).0;
        (x * (TAU * phase).cos(), x * (TAU * phase).sin())
    };
    let sum = (0..SAMPLES).map(sample).fold((0.0, 0.0), |sum, (c, s)| (sum.0 + c, sum.1 + s));
    (2.0 * sum.0 / SAMPLES as f64, 2.0 * sum.1 / SAMPLES as f64)
}

/// omega of the true motion; its path is not computed if the energy gives the frequency.
pub(super) fn true_frequency(
    oscillator: &Oscillator,
    meant: &OrbitTarget,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<f64, VerificationError> {
    let physics = NumericOscillator::new(oscillator, meant, numbers)?;
    match &meant.limit_cycle {
        Some(near) => Ok(TAU / physics.limit_cycle(near)?.period()),
        None => physics.frequency(meant.amplitude_at(numbers)),
    }
}

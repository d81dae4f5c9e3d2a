//! The motion by the slow equations of amplitude and phase with numbers, solved from their start.
//!
//! ```text
//! x = X(a, theta),   x' = V = a' X_a + theta' X_theta,   x'' = a' V_a + theta' V_theta
//! ```

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use super::VerificationError;
use crate::exact::rational::from_f64;
use crate::expr::{CompiledFunction, Expr, ExprError};
use crate::numeric::ode::root::find_root;
use crate::numeric::ode::{IntegrationOptions as Integration, Point, integrate_first_order};
use crate::solution::modulation::Release;
use crate::solution::{AmplitudeConvention, Method, Modulation, Solution};
use crate::symbol::Symbol;

/// Largest number of periods that are followed.
const MOST_PERIODS: f64 = 50.0;
/// Least number of periods that are followed.
const LEAST_PERIODS: f64 = 3.0;
/// Number of samples of a motion per period.
pub(super) const LOOKS: f64 = 32.0;

/// The slow equations with numbers, solved from the start.
pub(super) struct SlowMotion {
    /// Amplitude and phase at a time.
    slow: SlowSolution,
    /// The motion about the equilibrium in amplitude and phase, and its rate.
    place: CompiledFunction,
    speed: CompiledFunction,
    /// The second time derivative, if it has an expression.
    acceleration: Option<CompiledFunction>,
    pub(super) equilibrium: f64,
    /// The amplitude at the start.
    start: f64,
    /// An angle added to the initial phase: pi for a negative amplitude, because the formula takes
    /// the absolute value.
    turn: f64,
    /// 2 pi over the rate of the phase there.
    pub(super) period: f64,
    /// The steady amplitudes.
    steady: Vec<f64>,
    /// The time at which the amplitude is zero, by its closed form.
    ends: f64,
    /// Whether the order is high enough to give the shift of the turning points from the phases 0
    /// and pi that the drift of the amplitude causes.
    drift_counts: bool,
}

/// Amplitude and phase at a time.
type SlowPath = Box<dyn Fn(f64) -> Option<[f64; 2]>>;

/// The representation of amplitude and phase.
enum SlowSolution {
    /// In closed form, in the time.
    Closed([CompiledFunction; 2]),
    /// Point by point, at equal steps, with as many rates.
    Followed(SlowPath),
}

/// The numbers of a motion released at rest.
struct ReleaseValues {
    /// Parameters, definitions and the amplitude at the start, positive even if a negative one is
    /// given and counts as half a turn.
    known: BTreeMap<Symbol, f64>,
    /// These values as exact numbers.
    exact: BTreeMap<Symbol, Expr>,
    /// Whether a negative amplitude is taken as half a turn.
    turned: bool,
    /// Whether closed forms, which are written for positive amplitudes, hold.
    closed_forms_hold: bool,
}

impl ReleaseValues {
    /// # Errors
    /// A definition without a value.
    fn new(
        solution: &Solution,
        modulation: &Modulation,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<Self, VerificationError> {
        let value_of = |name: Symbol| numbers.get(&name).copied();
        let defined = solution
            .defined_values(&value_of)
            .map_err(|name| VerificationError::Missing(vec![name]))?;
        let mut known = numbers.clone();
        known.extend(defined);
        // Slow equations are written for positive amplitudes; those of a polynomial force hold for
        // any.
        let released = AmplitudeConvention::Initial.symbol();
        let negative = known.get(&released).is_some_and(|value| *value < 0.0);
        let simple = modulation.release.as_ref().is_none_or(Release::is_at_start);
        let turned = negative && simple;
        if turned && let Some(value) = known.get_mut(&released) {
            *value = -*value;
        }
        let exact =
            known.iter().filter_map(|(name, value)| Some((*name, Expr::number(from_f64(*value)?))));
        Ok(Self { exact: exact.collect(), known, turned, closed_forms_hold: !negative || simple })
    }

    fn evaluate_known(&self, expression: &Expr) -> Result<Expr, ExprError> {
        expression.substitute_all(&self.exact)
    }

    /// Amplitude and phase at the start.
    fn start(&self, modulation: &Modulation) -> Result<[f64; 2], VerificationError> {
        Ok(match &modulation.release {
            Some(release) => {
                [release.amplitude.evaluate(&self.known)?, release.phase.evaluate(&self.known)?]
            }
            None => {
                let released = self.known.get(&AmplitudeConvention::Initial.symbol());
                [released.copied().unwrap_or(1.0), 0.0]
            }
        })
    }

    /// Amplitude and phase in closed form; `None` if there is none that holds here.
    fn closed_form(&self, modulation: &Modulation) -> Option<[CompiledFunction; 2]> {
        let transient = modulation.transient.as_ref().filter(|_| self.closed_forms_hold)?;
        let compiled = |expression: &Expr| {
            CompiledFunction::new(&self.evaluate_known(expression).ok()?, &[Symbol::new("t")]).ok()
        };
        Some([compiled(&transient.amplitude)?, compiled(transient.phase.as_ref()?)?])
    }
}

/// The motion about its equilibrium, in the amplitude and `theta`.
fn displacement(solution: &Solution, theta: Symbol) -> Result<Expr, ExprError> {
    let mut waves = vec![-&solution.equilibrium];
    for (k, cosine, sine) in solution.displacement.harmonics() {
        let angle = &Expr::from(k as i64) * &Expr::from(theta);
        waves.push(&Expr::from(&cosine) * &angle.cos()?);
        waves.push(&Expr::from(&sine) * &angle.sin()?);
    }
    Ok(Expr::sum(waves))
}

impl SlowMotion {
    /// # Errors
    /// A value is missing, or the rate of the phase is not positive.
    pub(super) fn new(
        solution: &Solution,
        modulation: &Modulation,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<Self, VerificationError> {
        let equilibrium = solution.equilibrium.evaluate(numbers)?;
        let numbers = ReleaseValues::new(solution, modulation, numbers)?;
        let (a, theta) = (modulation.amplitude, solution.phase());
        let place = numbers.evaluate_known(&displacement(solution, theta)?)?;
        let rates = [
            numbers.evaluate_known(&modulation.amplitude_rate)?,
            numbers.evaluate_known(&modulation.phase_rate)?,
        ];
        let moved = |of: &Expr| -> Result<Expr, ExprError> {
            let slopes = [of.differentiate(a)?, of.differentiate(theta)?];
            Ok(&slopes[0] * &rates[0] + &slopes[1] * &rates[1])
        };
        let speed = moved(&place)?;
        let both = [a, theta];
        let acceleration = moved(&speed).ok();
        let start = numbers.start(modulation)?;
        let frequency = CompiledFunction::new(&rates[1], &[a])?.call(&[start[0]]);
        if !(frequency > 0.0 && frequency.is_finite()) {
            return Err(VerificationError::NoSlowFrequency);
        }
        let period = TAU / frequency;
        let slow = match numbers.closed_form(modulation) {
            Some(closed) => SlowSolution::Closed(closed),
            None => {
                SlowSolution::Followed(followed(a, &rates, start, 2.0 * MOST_PERIODS * period)?)
            }
        };
        let transient = modulation.transient.as_ref();
        let ends = transient.and_then(|transient| transient.ends.as_ref());
        let ends = ends.and_then(|ends| ends.evaluate(&numbers.known).ok());
        let steady = modulation.steady.iter();
        let steady = steady.filter_map(|cycle| cycle.amplitude.evaluate(&numbers.known).ok());
        Ok(Self {
            slow,
            place: CompiledFunction::new(&place, &both)?,
            speed: CompiledFunction::new(&speed, &both)?,
            acceleration: acceleration
                .and_then(|expression| CompiledFunction::new(&expression, &both).ok()),
            equilibrium,
            start: start[0],
            turn: if numbers.turned { PI } else { 0.0 },
            period,
            steady: steady.collect(),
            ends: ends.filter(|ends| *ends > 0.0).unwrap_or(f64::INFINITY),
            drift_counts: solution.order > 2 || solution.method == Method::Exact,
        })
    }

    /// Amplitude and phase at a time; the amplitude stays zero once it has reached zero.
    fn slow_at(&self, t: f64) -> [f64; 2] {
        let [amplitude, phase] = match &self.slow {
            SlowSolution::Closed([amplitude, phase]) => [amplitude.call(&[t]), phase.call(&[t])],
            SlowSolution::Followed(of) => of(t).unwrap_or([f64::NAN; 2]),
        };
        let over = t >= self.ends || amplitude * self.start <= 0.0;
        [if over { 0.0 } else { amplitude }, phase + self.turn]
    }

    /// Distance from the equilibrium and velocity.
    pub(super) fn phase_point_at(&self, t: f64) -> (f64, f64) {
        let at = self.slow_at(t);
        match at[0] == 0.0 {
            true => (0.0, 0.0),
            false => (self.place.call(&at), self.speed.call(&at)),
        }
    }

    /// The acceleration; `None` if it has no expression.
    pub(super) fn acceleration(&self, t: f64) -> Option<f64> {
        let acceleration = self.acceleration.as_ref()?;
        let at = self.slow_at(t);
        Some(if at[0] == 0.0 { 0.0 } else { acceleration.call(&at) })
    }

    /// Distance from the equilibrium for the amplitude at this time and any phase.
    pub(super) fn at_phase(&self, t: f64, phase: f64) -> f64 {
        let [a, _] = self.slow_at(t);
        if a == 0.0 { 0.0 } else { self.place.call(&[a, phase]) }
    }

    /// The extremum of the formula on the side of a true turning point.
    pub(super) fn turned(&self, t: f64, x: f64) -> f64 {
        let turn = |side: f64| {
            let speed = |phase: f64| self.speed.call(&[self.slow_at(t)[0], phase]);
            let phase = match self.drift_counts {
                true => find_root(speed, side - 0.5, side + 0.5).unwrap_or(side),
                false => side,
            };
            self.at_phase(t, phase)
        };
        let same = [0.0, PI].map(turn).into_iter().find(|side| side * x >= 0.0);
        same.unwrap_or(f64::NAN)
    }

    /// The times at which the formula goes through the equilibrium.
    pub(super) fn crossings(&self, until: f64) -> Vec<f64> {
        let count = (LOOKS * until / self.period).ceil().max(1.0) as usize;
        let time = |k: usize| until * k as f64 / count as f64;
        let mut before = (0.0, self.phase_point_at(0.0).0);
        let mut found = vec![];
        for k in 1..=count {
            let now = (time(k), self.phase_point_at(time(k)).0);
            if before.1 * now.1 < 0.0
                && let Ok(t) = find_root(|t| self.phase_point_at(t).0, before.0, now.0)
            {
                found.push(t);
            }
            before = now;
        }
        found
    }

    /// The time at which the amplitude has fallen to a size.
    pub(super) fn falls_to(&self, size: f64, longest: f64) -> Option<f64> {
        self.falls_below(|t| self.slow_at(t)[0].abs(), size, longest)
    }

    /// The time at which the distance of the turning points from the equilibrium has fallen to a
    /// size.
    pub(super) fn turns_at(&self, distance: f64, longest: f64) -> Option<f64> {
        self.falls_below(|t| self.turned(t, 1.0).abs(), distance, longest)
    }

    fn falls_below(&self, measure: impl Fn(f64) -> f64, size: f64, longest: f64) -> Option<f64> {
        let excess = |t: f64| measure(t) - size;
        let count = (8.0 * longest / self.period).ceil().max(1.0) as usize;
        let time = |k: usize| longest * k as f64 / count as f64;
        let place = (1..=count).find(|&k| excess(time(k)) <= 0.0)?;
        if excess(time(place - 1)) <= 0.0 {
            return None;
        }
        find_root(excess, time(place - 1), time(place)).ok()
    }

    /// The time for which the motion is worth following, and the reason for its end.
    pub(super) fn duration(&self) -> (f64, &'static str) {
        let longest = MOST_PERIODS * self.period;
        let start = self.start.abs();
        let settles = |a: f64| {
            let near = |steady: &f64| (a.abs() / steady - 1.0).abs() < 0.01;
            self.steady.iter().any(near)
                && !self.steady.iter().any(|steady| (start / steady - 1.0).abs() < 0.01)
        };
        let steps = 8 * MOST_PERIODS as usize;
        for k in 1..=steps {
            let t = longest * k as f64 / steps as f64;
            let a = self.slow_at(t)[0].abs();
            let reason = match a {
                _ if !a.is_finite() => "the formula ends",
                _ if a <= start / 10.0 => "the amplitude is a tenth",
                _ if a >= 10.0 * start => "the amplitude is ten times that of the start",
                _ if settles(a) => "the amplitude is within 1 % of one that stays",
                _ => continue,
            };
            let exact = match a <= start / 10.0 {
                true => self.falls_to(start / 10.0, t).unwrap_or(t),
                false => t,
            };
            let least = LEAST_PERIODS * self.period;
            return match exact < least && a.is_finite() {
                true => (least, "three periods"),
                false => (exact, reason),
            };
        }
        (longest, "50 periods")
    }
}

/// Amplitude and phase by integration of the slow equations.
fn followed(
    a: Symbol,
    rates: &[Expr; 2],
    start: [f64; 2],
    duration: f64,
) -> Result<SlowPath, VerificationError> {
    let [amplitude, phase] = rates.each_ref().map(|rate| CompiledFunction::new(rate, &[a]));
    let (amplitude, phase) = (amplitude?, phase?);
    let rates = move |_: f64, values: &[f64; 2], rates: &mut [f64; 2]| {
        // The motion is over once the amplitude has changed its sign.
        let over = values[0] * start[0] <= 0.0;
        *rates = match over {
            true => [0.0, 0.0],
            false => [amplitude.call(&values[..1]), phase.call(&values[..1])],
        };
    };
    let options = Integration::with_tolerance(1e-11 * f64::min(1.0, start[0].abs()));
    let begin = Point { t: 0.0, y: start };
    let path = integrate_first_order(rates, begin, duration, &[], &options)
        .map_err(|_| VerificationError::NoSlowFrequency)?;
    Ok(Box::new(move |t| path.state_at(t).map(|point| point.y)))
}

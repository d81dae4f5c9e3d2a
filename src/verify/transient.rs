//! The judge of motions that are not periodic: slow equations of amplitude and phase against the equation as it was typed.
//!
//! ```text
//! released at rest from x = A, followed until the amplitude has fallen to A/10, grown to 10 A, settled within 1 % of one that
//! stays, or 50 periods have gone by, but at least three of them
//! true_frequency = pi (n - 1)/(t_n - t_1)       t_k the times at which the motion goes through its equilibrium
//! frequency      = the same of the formula, with as many of its own
//! amplitude_error = max |x_formula - x_true|/|A|  at the true turning points, x_formula that of the same half swing at its turn
//! max_deviation  = max |x_formula(t) - x_true(t)|/|A|
//! ```

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use super::free_motion::{FreeMotion, Start};
use super::validity::Range;
use super::{Motions, Sample, Verdict, Verification, VerificationError};
use crate::decimal::decimal;
use crate::exact::rational::from_f64;
use crate::expr::{CompiledFunction, Expr};
use crate::method::averaging::action::falls_to;
use crate::method::numbers::{NoNumbers, symbol_values};
use crate::numeric::ode::root::find_root;
use crate::numeric::ode::{Options as Integration, Point, integrate_first_order};
use crate::oscillator::Oscillator;
use crate::solution::modulation::Release;
use crate::solution::{AmplitudeConvention, Modulation, Solution};
use crate::symbol::Symbol;
use crate::values::Values;

/// What else is known of a motion that was followed from its start.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Followed {
    /// How long it was followed, in the time of the equation.
    pub until: f64,
    /// Why no longer, in words.
    pub reason: &'static str,
    /// The number of times at which the formula and the true motion both went through the equilibrium.
    pub crossings: usize,
    /// The largest error of the turning points, over the amplitude at the start.
    pub amplitude_error: Option<f64>,
    /// When the amplitude is a tenth of that of the start: by the formula.
    pub tenth: Option<f64>,
    /// By the action, which viscous damping drains at one rate whatever the force; `None` for any other damping.
    pub tenth_by_action: Option<f64>,
    /// The same in truth, between turning points on the logarithm.
    pub true_tenth: Option<f64>,
}

/// Periods after which a motion is left.
const MOST_PERIODS: f64 = 50.0;
/// Periods that are always followed.
const LEAST_PERIODS: f64 = 3.0;
/// How often in a period a motion is looked at.
const LOOKS: f64 = 32.0;

/// Judges slow equations from a start.
///
/// # Errors
/// The motion cannot be followed, or it does not swing.
pub(super) fn judge(
    oscillator: &Oscillator,
    solution: &Solution,
    modulation: &Modulation,
    at: &Values,
    numbers: &BTreeMap<Symbol, f64>,
    tolerance: f64,
) -> Result<Verification, VerificationError> {
    let symbols = symbol_values(oscillator, solution, numbers, None);
    let judged = Judged::of(oscillator, solution, modulation, numbers)?;
    let Judged {
        slow,
        truth,
        until,
        reason,
        start,
    } = &judged;
    let crossings = slow.crossings(*until);
    let own: Vec<f64> = truth.crossings.iter().copied().filter(|t| t <= until).collect();
    let count = own.len().min(crossings.len());
    let mean = |times: &[f64]| match times {
        [first, .., last] => Some(PI * (times.len() - 1) as f64 / (last - first)),
        _ => None,
    };
    let reference = if count < 2 { &own[..] } else { &own[..count] };
    let true_frequency = mean(reference).ok_or(VerificationError::NoSwing)?;
    let frequency = mean(&crossings[..count]);
    let relative_error = frequency.map(|frequency| frequency / true_frequency - 1.0);
    let turns = truth.turns.iter().filter(|(t, _)| t <= until);
    let apart = turns.map(|&(t, x)| (slow.turned(t, x) - x).abs() / start.abs());
    let amplitude_error = largest(apart);
    let times = (0..=samples(*until, slow.period)).map(|k| until * k as f64 / samples(*until, slow.period) as f64);
    let deviation = largest(times.map(|t| (slow.at(t).0 - truth.at(t).0).abs() / start.abs()));
    let pass = relative_error.is_some_and(|error| error.abs() <= tolerance);
    let outside = amplitude_error.is_none_or(|error| error > tolerance);
    let ranges = amplitude_error.map(|error| Range {
        text: format!(
            "the amplitude errs by {} of that at the start at most, followed to t = {}",
            crate::decimal::significant(error, 3),
            decimal(*until)
        ),
        outside,
    });
    Ok(Verification {
        at: at.clone(),
        frequency,
        reason: frequency.is_none().then_some(NoNumbers::NoValue),
        true_frequency,
        relative_error,
        judged_on: "omega",
        error_of_omega: None,
        max_deviation: deviation,
        residual: None,
        slope: None,
        ranges: ranges.filter(|range| range.outside).into_iter().collect(),
        chosen: vec![],
        values: symbols.values,
        phase: 0.0,
        motion: None,
        steady_states: vec![],
        followed: Some(Followed {
            until: *until,
            reason,
            crossings: count,
            amplitude_error,
            tenth: slow.falls_to(start.abs() / 10.0, truth.end()),
            tenth_by_action: falls_to(oscillator, &solution.equilibrium, numbers, [*start, start / 10.0]),
            true_tenth: truth.falls_to(start.abs() / 10.0),
        }),
        verdict: Verdict::of(pass),
    })
}

/// The motion by the slow equations and the true one, at the same instants.
///
/// # Errors
/// As for [`judge`].
pub(super) fn motions(
    oscillator: &Oscillator,
    solution: &Solution,
    modulation: &Modulation,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Motions, VerificationError> {
    let judged = Judged::of(oscillator, solution, modulation, numbers)?;
    let rest = judged.slow.equilibrium;
    let count = samples(judged.until, judged.slow.period);
    let time = |k: usize| judged.until * k as f64 / count as f64;
    let sample = |t: f64, (y, v): (f64, f64)| -> Sample { (t, rest + y, v) };
    let times = || (0..=count).map(time);
    let envelope = |t: f64| [0.0, PI].map(|phase| (t, rest + judged.slow.at_phase(t, phase)));
    let [upper, lower] = [0, 1].map(|side| times().map(|t| envelope(t)[side]).collect());
    Ok(Motions {
        formula: times().map(|t| sample(t, judged.slow.at(t))).collect(),
        truth: times().map(|t| sample(t, judged.truth.at(t))).collect(),
        envelope: Some([upper, lower]),
    })
}

/// Enough points for the eye and for the largest deviation.
fn samples(until: f64, period: f64) -> usize {
    const PER_PERIOD: f64 = 64.0;
    let count = (PER_PERIOD * until / period).ceil();
    if count.is_finite() {
        (count as usize).clamp(64, 8192)
    } else {
        64
    }
}

/// The largest of numbers that are all finite; `None` where there is none.
fn largest(values: impl Iterator<Item = f64>) -> Option<f64> {
    let found = values.fold(None, |largest: Option<f64>, value| {
        Some(match largest {
            Some(known) if known.is_nan() || known >= value => known,
            _ => value,
        })
    });
    found.filter(|value| value.is_finite())
}

/// Formula and truth from one start.
struct Judged {
    slow: SlowMotion,
    truth: FreeMotion,
    until: f64,
    reason: &'static str,
    start: f64,
}

impl Judged {
    fn of(
        oscillator: &Oscillator,
        solution: &Solution,
        modulation: &Modulation,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<Self, VerificationError> {
        let start = numbers
            .get(&AmplitudeConvention::Initial.symbol())
            .copied()
            .unwrap_or(1.0);
        let slow = SlowMotion::new(solution, modulation, numbers)?;
        let (until, reason) = slow.duration();
        let truth = FreeMotion::of(
            oscillator,
            numbers,
            &Start {
                equilibrium: slow.equilibrium,
                distance: start,
                // The true amplitude may come down to a tenth a little later.
                duration: until + f64::max(slow.period, 0.1 * until),
                step: slow.period / LOOKS,
            },
        )?;
        Ok(Self {
            until: until.min(truth.end()),
            slow,
            truth,
            reason,
            start,
        })
    }
}

/// The slow equations with numbers, solved from the start.
struct SlowMotion {
    /// Amplitude and phase at a time.
    slow: Slow,
    /// The motion about the equilibrium in amplitude and phase, and its slopes by both.
    place: CompiledFunction,
    slopes: [CompiledFunction; 2],
    rates: [CompiledFunction; 2],
    equilibrium: f64,
    /// The amplitude at the start.
    start: f64,
    /// What the phase begins with beside its own start: pi for a negative one, whose size the formula takes.
    turn: f64,
    /// 2 pi over the rate of the phase there.
    period: f64,
    /// The amplitudes that stay.
    steady: Vec<f64>,
    /// When the amplitude is zero, by its closed form.
    ends: f64,
}

/// Amplitude and phase at a time.
type SlowPath = Box<dyn Fn(f64) -> Option<[f64; 2]>>;

/// How amplitude and phase are known.
enum Slow {
    /// In closed form, in the time.
    Closed([CompiledFunction; 2]),
    /// Point by point, at equal steps, with as many rates.
    Followed(SlowPath),
}

impl SlowMotion {
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
        // Slow equations are written for positive amplitudes; those of a polynomial force hold for any.
        let released = AmplitudeConvention::Initial.symbol();
        let negative = known.get(&released).is_some_and(|value| *value < 0.0);
        let simple = modulation.release.as_ref().is_none_or(Release::is_at_start);
        let turned = negative && simple;
        if turned && let Some(value) = known.get_mut(&released) {
            *value = -*value;
        }
        let exact = known
            .iter()
            .filter_map(|(name, value)| Some((*name, Expr::number(from_f64(*value)?))));
        let exact: BTreeMap<Symbol, Expr> = exact.collect();
        let with_numbers = |expression: &Expr| expression.substitute_all(&exact);
        let (a, theta, t) = (modulation.amplitude, Symbol::new("theta"), Symbol::new("t"));
        let equilibrium = solution.equilibrium.evaluate(numbers)?;
        let mut waves = vec![-&solution.equilibrium];
        for (k, cosine, sine) in solution.displacement.harmonics() {
            let angle = &Expr::from(k as i64) * &Expr::from(theta);
            waves.push(&Expr::from(&cosine) * &angle.cos()?);
            waves.push(&Expr::from(&sine) * &angle.sin()?);
        }
        let place = with_numbers(&Expr::sum(waves))?;
        let slope = |by: Symbol| -> Result<_, VerificationError> {
            Ok(CompiledFunction::new(&place.differentiate(by)?, &[a, theta])?)
        };
        let slopes = [slope(a)?, slope(theta)?];
        let rate = |expression: &Expr| -> Result<_, VerificationError> {
            Ok(CompiledFunction::new(&with_numbers(expression)?, &[a])?)
        };
        let rates = [rate(&modulation.amplitude_rate)?, rate(&modulation.phase_rate)?];
        let begins = modulation.release.as_ref();
        let begin = |expression: Option<&Expr>, other: f64| match expression {
            Some(expression) => expression.evaluate(&known),
            None => Ok(other),
        };
        let released = known.get(&released).copied().unwrap_or(1.0);
        let start = [
            begin(begins.map(|release| &release.amplitude), released)?,
            begin(begins.map(|release| &release.phase), 0.0)?,
        ];
        let frequency = rates[1].call(&[start[0]]);
        if !(frequency > 0.0 && frequency.is_finite()) {
            return Err(VerificationError::NoSlowFrequency);
        }
        let period = TAU / frequency;
        let closed = modulation
            .transient
            .as_ref()
            .filter(|_| !negative || simple)
            .and_then(|transient| {
                let phase = transient.phase.as_ref()?;
                let compiled = |expression: &Expr| CompiledFunction::new(&with_numbers(expression).ok()?, &[t]).ok();
                Some([compiled(&transient.amplitude)?, compiled(phase)?])
            });
        let slow = match closed {
            Some(closed) => Slow::Closed(closed),
            None => Slow::Followed(followed(modulation, &with_numbers, start, 2.0 * MOST_PERIODS * period)?),
        };
        let ends = modulation
            .transient
            .as_ref()
            .and_then(|transient| transient.ends.as_ref());
        let ends = ends.and_then(|ends| ends.evaluate(&known).ok());
        let steady = modulation
            .steady
            .iter()
            .filter_map(|cycle| cycle.amplitude.evaluate(&known).ok());
        Ok(Self {
            slow,
            place: CompiledFunction::new(&place, &[a, theta])?,
            slopes,
            rates,
            equilibrium,
            start: start[0],
            turn: if turned { PI } else { 0.0 },
            period,
            steady: steady.collect(),
            ends: ends.filter(|ends| *ends > 0.0).unwrap_or(f64::INFINITY),
        })
    }

    /// Amplitude and phase; the amplitude zero once it has come down to that.
    fn slow_at(&self, t: f64) -> [f64; 2] {
        let [amplitude, phase] = match &self.slow {
            Slow::Closed([amplitude, phase]) => [amplitude.call(&[t]), phase.call(&[t])],
            Slow::Followed(of) => of(t).unwrap_or([f64::NAN; 2]),
        };
        let over = t >= self.ends || amplitude * self.start <= 0.0;
        [if over { 0.0 } else { amplitude }, phase + self.turn]
    }

    /// Distance from the equilibrium and velocity.
    fn at(&self, t: f64) -> (f64, f64) {
        let [a, phase] = self.slow_at(t);
        if a == 0.0 {
            return (0.0, 0.0);
        }
        let [by_amplitude, by_phase] = &self.slopes;
        let at = [a, phase];
        let velocity =
            by_amplitude.call(&at) * self.rates[0].call(&[a]) + by_phase.call(&at) * self.rates[1].call(&[a]);
        (self.place.call(&at), velocity)
    }

    /// Distance from the equilibrium at the amplitude of a time and any phase.
    fn at_phase(&self, t: f64, phase: f64) -> f64 {
        let [a, _] = self.slow_at(t);
        if a == 0.0 { 0.0 } else { self.place.call(&[a, phase]) }
    }

    /// Where the formula turns on the side of a true turning point.
    fn turned(&self, t: f64, x: f64) -> f64 {
        let sides = [0.0, PI].map(|phase| self.at_phase(t, phase));
        let same = sides.into_iter().find(|side| side * x >= 0.0);
        same.unwrap_or(f64::NAN)
    }

    /// The times at which the formula goes through the equilibrium.
    fn crossings(&self, until: f64) -> Vec<f64> {
        let count = (LOOKS * until / self.period).ceil().max(1.0) as usize;
        let time = |k: usize| until * k as f64 / count as f64;
        let mut before = (0.0, self.at(0.0).0);
        let mut found = vec![];
        for k in 1..=count {
            let now = (time(k), self.at(time(k)).0);
            if before.1 * now.1 < 0.0
                && let Ok(t) = find_root(|t| self.at(t).0, before.0, now.0)
            {
                found.push(t);
            }
            before = now;
        }
        found
    }

    /// When the amplitude comes down to a size.
    fn falls_to(&self, size: f64, longest: f64) -> Option<f64> {
        let excess = |t: f64| self.slow_at(t)[0].abs() - size;
        let count = (8.0 * longest / self.period).ceil().max(1.0) as usize;
        let time = |k: usize| longest * k as f64 / count as f64;
        let place = (1..=count).find(|&k| excess(time(k)) <= 0.0)?;
        if excess(time(place - 1)) <= 0.0 {
            return None;
        }
        find_root(excess, time(place - 1), time(place)).ok()
    }

    /// How long it is worth following, and why no longer.
    fn duration(&self) -> (f64, &'static str) {
        let longest = MOST_PERIODS * self.period;
        let start = self.start.abs();
        let settles = |a: f64| {
            let near = |steady: &f64| (a.abs() / steady - 1.0).abs() < 0.01;
            self.steady.iter().any(near) && !self.steady.iter().any(|steady| (start / steady - 1.0).abs() < 0.01)
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
    modulation: &Modulation,
    with_numbers: &dyn Fn(&Expr) -> Result<Expr, crate::expr::ExprError>,
    start: [f64; 2],
    duration: f64,
) -> Result<SlowPath, VerificationError> {
    let compiled = |expression: &Expr| -> Result<_, VerificationError> {
        Ok(CompiledFunction::new(
            &with_numbers(expression)?,
            &[modulation.amplitude],
        )?)
    };
    let (amplitude, phase) = (compiled(&modulation.amplitude_rate)?, compiled(&modulation.phase_rate)?);
    let rates = move |_: f64, values: &[f64; 2], rates: &mut [f64; 2]| {
        // Below zero nothing is left of the motion.
        let over = values[0] * start[0] <= 0.0;
        *rates = match over {
            true => [0.0, 0.0],
            false => [amplitude.call(&values[..1]), phase.call(&values[..1])],
        };
    };
    let options = Integration::with_tolerance(1e-11 * f64::min(1.0, start[0].abs()));
    let begin = Point { t: 0.0, y: start };
    let path =
        integrate_first_order(rates, begin, duration, &[], &options).map_err(|_| VerificationError::NoSlowFrequency)?;
    Ok(Box::new(move |t| path.state_at(t).map(|point| point.y)))
}

//! The derived reading: approach and return are a derived motion with all its harmonics, and the
//! joins follow from it.
//!
//! In: the swing and its values, a release, a barrier, a method with its order. Out: three phases,
//! continuous at every join in place and speed. With X the derived displacement from its turning
//! point at t = 0, even in t:
//!
//! ```text
//! approach   x = X(t)                X(t1) = x_c, the first root         v = |X'(t1)|
//! contact    x = x_c + d(t - t1)     d by a contact law entered at v     d(t2 - t1) = 0
//! return     x = X(t - t3)           t3 = t2 + t1, the turning point after the impact and the period
//! ```
//!
//! The pendulum leaves a contact that loses energy with less speed: then X of the return is the
//! motion whose amplitude gives this speed at the barrier, and t3 - t2 is its time.
//!
//! The swing is derived as it is released, from its upper turning point: if the release is the
//! lower one, the equation of -x is derived.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::contact::{ContactMotion, LossyContact, SineSeries};
use super::error::ImpactError;
use super::form::Form;
use super::phases::{MotionPhase, ThreePhases};
use super::setup::ImpactEquations;
use crate::exact::{Doubles, from_f64};
use crate::expr::{Equation, Expr};
use crate::method::motion::Motion;
use crate::method::{self, is_odd};
use crate::numeric::ode::root::find_root;
use crate::oscillator::Oscillator;
use crate::series::FourierSeries;
use crate::solution::{AmplitudeConvention, Method, Solution};

/// The derived swing, x(t) = sign X(t) with X released from its upper turning point.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Flight {
    /// The answer of the method, for X.
    pub solution: Solution,
    /// The value of its amplitude symbol, in the unit of x.
    pub amplitude: f64,
    /// 1, or -1 where the release is the lower turning point: X = -x.
    pub sign: f64,
    /// Whether the equation of -x differs from that of x; it does not if the force is odd.
    pub is_turned: bool,
    /// X in numbers.
    pub motion: Motion,
}

impl Flight {
    /// Derives the swing released at rest from `release`; `sign` is 1 where that is its upper
    /// turning point, -1 where it is the lower one. `equilibrium` is that of `swing` at these
    /// values.
    ///
    /// # Errors
    /// [`ImpactError`].
    pub(super) fn derive(
        equations: &ImpactEquations,
        [release, sign]: [f64; 2],
        options: &method::Options,
    ) -> Result<Self, ImpactError> {
        let swing = &equations.swing;
        let turned = if sign < 0.0 { mirrored_equation(swing)? } else { None };
        // A swing between barriers is free: methods of free motions refuse a drive.
        let options = &method::Options {
            method: options.method.or(Some(Method::LindstedtPoincare)),
            ..options.clone()
        };
        let solution = method::solve(turned.as_ref().unwrap_or(swing), options)?;
        let (from, distance) = (sign * release, sign * (release - equations.equilibrium));
        let motion_at = |amplitude: f64| motion_at(&solution, equations, amplitude);
        let amplitude = match solution.amplitude {
            AmplitudeConvention::Initial => distance,
            AmplitudeConvention::FirstHarmonic => {
                // The amplitude is of the size of the distance, because the other harmonics are
                // smaller than the first.
                let short = |amplitude| {
                    motion_at(amplitude)
                        .map_or(f64::NAN, |motion| motion.displacement_at(0.0) - from)
                };
                find_root(short, 0.25 * distance, 2.0 * distance)
                    .map_err(|_| ImpactError::NoAmplitude)?
            }
        };
        let motion = motion_at(amplitude)?;
        let start = motion.displacement_at(0.0);
        // An answer that is not a number fails as well.
        let starts_there = (start - from).abs() <= 1e-6 * distance.abs();
        match starts_there {
            true => Ok(Self { solution, amplitude, sign, is_turned: turned.is_some(), motion }),
            false => Err(ImpactError::Start { start: sign * start, release }),
        }
    }

    /// The swing with the amplitude, no larger than this one, that passes the barrier at this
    /// speed.
    ///
    /// # Errors
    /// [`ImpactError::WayBack`]; the method has no motion at that amplitude.
    pub(super) fn passing(
        &self,
        equations: &ImpactEquations,
        barrier: f64,
        speed: f64,
    ) -> Result<Self, ImpactError> {
        let of = |amplitude: f64| -> Result<Self, ImpactError> {
            Ok(Self {
                amplitude,
                motion: motion_at(&self.solution, equations, amplitude)?,
                ..self.clone()
            })
        };
        let excess = |amplitude: f64| {
            let touched = of(amplitude).and_then(|flight| flight.touch(barrier));
            // Too small a swing does not reach the barrier.
            touched.map_or(-1.0, |(_, found)| (found / speed).powi(2) - 1.0)
        };
        let amplitude =
            find_root(excess, 0.0, self.amplitude).map_err(|_| ImpactError::WayBack(speed))?;
        of(amplitude)
    }

    /// The time from the release to this place, and the speed there.
    ///
    /// # Errors
    /// [`ImpactError::NeverReaches`].
    pub fn touch(&self, barrier: f64) -> Result<(f64, f64), ImpactError> {
        let half = PI / self.motion.frequency();
        let place = self.sign * barrier;
        let never = |_| ImpactError::NeverReaches {
            from: self.sign * self.motion.displacement_at(0.0),
            to: self.sign * self.motion.displacement_at(half),
        };
        let displacement = self.motion.displacement();
        let number = |series: FourierSeries<Doubles>| series.mean().0;
        // A single wave has the closed form of the paper, more waves have a root in the half
        // period.
        let cosine = (place - number(displacement.cosine(0))) / number(displacement.cosine(1));
        let time = match displacement.highest_harmonic() {
            1 if displacement.is_even() && cosine.abs() <= 1.0 => {
                cosine.acos() / self.motion.frequency()
            }
            _ => find_root(|t| self.motion.displacement_at(t) - place, 0.0, half).map_err(never)?,
        };
        Ok((time, self.motion.velocity(time).abs()))
    }

    /// The motion as a closed form, its clock at a turning point.
    pub fn form(&self) -> Form {
        let displacement = self.motion.displacement();
        let part = |series: FourierSeries<Doubles>| self.sign * series.mean().0;
        let wave = |k: usize| {
            let amplitude =
                Complex64::new(part(displacement.cosine(k)), -part(displacement.sine(k)));
            (amplitude != Complex64::ZERO).then_some((k as u32, amplitude))
        };
        Form::Harmonics {
            centre: part(displacement.cosine(0)),
            frequency: self.motion.frequency(),
            harmonics: (1..=displacement.highest_harmonic()).filter_map(wave).collect(),
        }
    }
}

/// The motion of a law at this amplitude.
fn motion_at(
    solution: &Solution,
    equations: &ImpactEquations,
    amplitude: f64,
) -> Result<Motion, ImpactError> {
    let symbol = solution.amplitude.symbol();
    let (_, mut values) = equations.values.split(&[symbol]);
    let exact = from_f64(amplitude).ok_or(ImpactError::NoAmplitude)?;
    values.insert(symbol, Expr::number(exact))?;
    Ok(solution.motion_at(&values)?)
}

/// The equation of -x; `None` if it is that of x.
fn mirrored_equation(swing: &Oscillator) -> Result<Option<Oscillator>, ImpactError> {
    let x = swing.coordinate;
    if is_odd(&swing.force, x)? {
        return Ok(None);
    }
    let acceleration = x.derivative().derivative();
    let turned = swing
        .residual
        .substitute_all(&[x, acceleration].map(|name| (name, -&Expr::from(name))).into())?;
    let equation = Equation { left: -&turned, right: Expr::zero(), ..swing.equation() };
    let about = swing.about.as_ref().map(|about| -about);
    Ok(Some(Oscillator { about, ..Oscillator::from_equation(&equation)? }))
}

/// Largest deviation of the printed series of a contact from its motion, over the depth.
const SERIES: f64 = 1e-6;

/// The contact of the derived phases.
#[derive(Clone, Debug, PartialEq)]
pub enum DerivedContact {
    /// A contact without losses.
    Elastic(Box<ContactMotion>),
    /// A contact that loses energy, without the force of the swing.
    Lossy(Box<LossyContact>),
}

impl DerivedContact {
    /// Its greatest depth, duration, and exit speed for the entry speed `speed`.
    fn numbers(&self, speed: f64) -> [f64; 3] {
        match self {
            Self::Elastic(contact) => [contact.depth, contact.duration, speed],
            Self::Lossy(contact) => {
                let numbers = contact.numbers();
                [numbers.depth, numbers.duration, numbers.exit_speed]
            }
        }
    }

    /// Its motion in elementary functions.
    fn sine_series(&self) -> SineSeries {
        match self {
            Self::Elastic(contact) => contact.sine_series(SERIES),
            Self::Lossy(contact) => {
                let numbers = contact.numbers();
                SineSeries::from_motion(
                    |time| contact.position(time),
                    numbers.duration,
                    0.0,
                    numbers.depth,
                    SERIES,
                )
            }
        }
    }
}

/// The three phases: the flight, the contact on that side of the barrier entered at this time and
/// speed, the flight backwards.
///
/// # Errors
/// [`ImpactError`] where a contact that loses energy has no way back.
pub(super) fn phases_of(
    flight: &Flight,
    equations: &ImpactEquations,
    barrier: f64,
    [touch, speed]: [f64; 2],
    contact: &DerivedContact,
) -> Result<ThreePhases, ImpactError> {
    let [penetration, duration, exit_speed] = contact.numbers(speed);
    let (back, way_back) = match contact {
        DerivedContact::Elastic(_) => (flight.form(), touch),
        DerivedContact::Lossy(_) => {
            let back = flight.passing(equations, barrier, exit_speed)?;
            (back.form(), back.touch(barrier)?.0)
        }
    };
    let exit = touch + duration;
    let end = exit + way_back;
    let depth = contact.sine_series();
    let velocity_jump = depth.phase_point_at(0.0).1 - speed;
    let pressed = Form::Contact { barrier, inward: -flight.sign, depth };
    let phase =
        |name, [start, end, clock]: [f64; 3], form| MotionPhase { name, start, end, clock, form };
    Ok(ThreePhases {
        phases: [
            phase("approach", [0.0, touch, 0.0], flight.form()),
            phase("contact", [touch, exit, touch], pressed),
            phase("return", [exit, end, end], back),
        ],
        speed,
        exit_speed,
        penetration,
        duration,
        period: end,
        velocity_jump,
        fitted: None,
    })
}

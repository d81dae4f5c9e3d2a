//! Approach, contact, return: one impact of the pendulum in closed form, equations (13) to (16).
//!
//! In: an [`ImpactProblem`]: amplitude A, barrier x_c, stiffness gamma, the law omega^2 of the free
//! swing, the forces as closures. Out: [`ThreePhases`], the motion from release at x = -A back to
//! -A.
//!
//! ```text
//! approach   x = -A cos(omega t)                                  t1 = acos(-x_c/A)/omega          (13)
//! contact    x'' + k x + gamma (p x - q) = 0, x = x_c, x' = v     k = 1: sin x replaced by x        (15)
//!            x = centre + Re[Z exp(i kappa (t - t1))]             kappa^2 = k + gamma p, centre = gamma q/kappa^2,
//!                                                                 Z = (x_c - centre) - i v/kappa
//!            t2 - t1 = (2/kappa) atan2(v/kappa, x_c - centre)     where x = x_c again, at speed -v
//!            penetration = centre + |Z| - x_c
//! return     x = A cos(omega (t - t2) + acos(x_c/A))              back at -A at t2 + t1             (16)
//! ```
//!
//! The line p x - q is fitted over the depth that an impact of speed v reaches by its energy
//! ([`linearisation`]). Two readings of the speed of contact stand side by side, [`ContactSpeed`]:
//!
//! ```text
//! paper    v = A omega sin(acos(x_c/A)): the cosine's own speed, so every join is exactly continuous
//! energy   v = sqrt(2 (V(-A) - V(x_c))): exact for the original force; the velocity jumps at both joins
//! ```

use std::f64::consts::PI;
use std::fmt;

use super::collision::{Collision, CollisionError};
use super::contact::line::LineContact;
use super::error::ImpactError;
use super::form::{Form, TimeFunction};
use super::linearisation::{self, LinearContactForce, Rule};
use crate::decimal::significant;
use crate::series::terms;
use crate::symbol::Symbol;
use num_complex::Complex64;

/// One impact: x'' + f(x) + gamma F(x - x_c) = 0, released at rest from x = -amplitude towards the
/// barrier.
#[derive(Clone, Copy)]
pub struct ImpactProblem<'a> {
    /// Amplitude A > 0: the release is at x = -A.
    pub amplitude: f64,
    /// Position x_c of the barrier, between -A and A.
    pub barrier: f64,
    /// Dimensionless stiffness gamma > 0, equation (8).
    pub stiffness: f64,
    /// omega^2 of the free swing at this amplitude, from the derived law: 1 - A^2/8 for the paper.
    pub frequency_squared: f64,
    /// f'(0), which replaces f(x)/x in the contact; 1 for the pendulum.
    pub linear_stiffness: f64,
    /// f(x), the original force without the barrier.
    pub restoring_force: &'a dyn Fn(f64) -> f64,
    /// F(depth), the elastic force of the barrier per unit of gamma, such as
    /// [`hertz::elastic_force`](super::hertz::elastic_force).
    pub elastic_force: &'a dyn Fn(f64) -> f64,
    /// The rule that fits the line of equation (15).
    pub rule: Rule,
}

/// The speed at the touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactSpeed {
    /// The speed of the approximate cosine, as in the paper.
    Paper,
    /// The speed by the energy, exact for the original force.
    Energy,
}

impl fmt::Display for ContactSpeed {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Paper => "paper",
            Self::Energy => "energy",
        })
    }
}

/// The motion from release to release, in closed form.
#[derive(Debug, Clone, PartialEq)]
pub struct ThreePhases {
    /// Approach, contact, return.
    pub phases: [MotionPhase; 3],
    /// Speed v at first touch, in the units of x and time of the equation: rad times omega for the
    /// pendulum.
    pub speed: f64,
    /// Speed at the end of the contact, out of the barrier: less than `speed` where the contact
    /// loses energy.
    pub exit_speed: f64,
    /// Greatest depth of the closed form, in the unit of x.
    pub penetration: f64,
    /// Duration of the contact, in units of 1/omega for the pendulum.
    pub duration: f64,
    /// Time from the release to the turning point after the impact, in the same unit: if no energy
    /// is lost, the period.
    pub period: f64,
    /// Speed of contact minus the speed of the cosine at the barrier: the size of the jump of the
    /// velocity at the start and at the end of the contact. Zero for [`ContactSpeed::Paper`].
    pub velocity_jump: f64,
    /// The line that replaces the elastic force; `None` if none does.
    pub fitted: Option<FittedLine>,
}

/// The line of equation (15) in a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedLine {
    /// The line, per unit of gamma.
    pub line: LinearContactForce,
    /// Depth over which it was fitted, in the unit of x: d_max of the energy balance, gravity
    /// apart.
    pub depth: f64,
}

/// One phase of the motion.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionPhase {
    /// `approach`, `contact` or `return`.
    pub name: &'static str,
    /// Time at which it begins.
    pub start: f64,
    /// Time at which it ends.
    pub end: f64,
    /// The time from which its closed form counts, its clock: the start, or for a derived return
    /// the end.
    pub clock: f64,
    /// Its closed form, in the time from `clock`.
    pub form: Form,
}

/// The closed form of the motion, with this speed of contact.
///
/// # Errors
/// [`ImpactError`], each with what to change: a barrier out of reach, no stiffness, an amplitude
/// beyond the frequency law or outside the well.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{ContactSpeed, Rule, ImpactProblem, hertz::elastic_force, three_phases};
///
/// let swing = ImpactProblem {
///     amplitude: 1.5,
///     barrier: 0.323,
///     stiffness: 1e6,
///     frequency_squared: 1.0 - 1.5 * 1.5 / 8.0,
///     linear_stiffness: 1.0,
///     restoring_force: &f64::sin,
///     elastic_force: &elastic_force,
///     rule: Rule::LeastSquares,
/// };
/// let motion = three_phases(&swing, ContactSpeed::Energy)?;
/// assert!(motion.duration < 0.02 * motion.period);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn three_phases(
    swing: &ImpactProblem,
    column: ContactSpeed,
) -> Result<ThreePhases, ImpactError> {
    let &ImpactProblem {
        amplitude, barrier, stiffness, frequency_squared, linear_stiffness, ..
    } = swing;
    check(swing)?;
    let frequency = frequency_squared.sqrt();
    let swing_speed = frequency * (amplitude - barrier).sqrt() * (amplitude + barrier).sqrt();
    let energy_speed = swing.collision().contact_speed()?;
    let speed = match column {
        ContactSpeed::Paper => swing_speed,
        ContactSpeed::Energy => energy_speed,
    };
    let fitted_depth =
        linearisation::greatest_depth(swing.elastic_force, 0.5 * speed * speed / stiffness)?;
    let line = linearisation::fit(swing.rule, swing.elastic_force, fitted_depth)?;
    // In equation (15) the force of the swing is k x.
    let beside = [linear_stiffness * barrier, linear_stiffness];
    let contact = LineContact::new(line, stiffness, beside, speed)
        .ok_or(ImpactError::LinearStiffness(linear_stiffness))?;

    let phase = (barrier / amplitude).acos();
    // acos(-x_c/A) = pi - acos(x_c/A): time of approach and of return.
    let flight = (PI - phase) / frequency;
    let touch = flight;
    let exit = touch + contact.duration();
    let end = exit + flight;
    let oscillation = Form::Oscillation {
        centre: barrier - contact.centre,
        amplitude: Complex64::new(contact.centre, -speed / contact.frequency),
        frequency: contact.frequency,
    };
    Ok(ThreePhases {
        phases: [
            MotionPhase {
                name: "approach",
                start: 0.0,
                end: touch,
                clock: 0.0,
                form: Form::Cosine { amplitude: -amplitude, frequency, phase: 0.0 },
            },
            MotionPhase {
                name: "contact",
                start: touch,
                end: exit,
                clock: touch,
                form: oscillation,
            },
            MotionPhase {
                name: "return",
                start: exit,
                end,
                clock: exit,
                form: Form::Cosine { amplitude, frequency, phase },
            },
        ],
        speed,
        exit_speed: speed,
        penetration: contact.depth(),
        duration: contact.duration(),
        period: end,
        velocity_jump: speed - swing_speed,
        fitted: Some(FittedLine { line, depth: fitted_depth }),
    })
}

fn check(swing: &ImpactProblem) -> Result<(), ImpactError> {
    let &ImpactProblem { amplitude, frequency_squared, linear_stiffness, .. } = swing;
    if !(amplitude.is_finite() && amplitude > 0.0) {
        return Err(CollisionError::Amplitude(amplitude).into());
    }
    swing.collision().check()?;
    if !(frequency_squared.is_finite() && frequency_squared > 0.0) {
        return Err(ImpactError::BeyondTheLaw { frequency_squared, amplitude });
    }
    if !linear_stiffness.is_finite() {
        return Err(ImpactError::LinearStiffness(linear_stiffness));
    }
    Ok(())
}

impl ImpactProblem<'_> {
    /// The collision without approximations.
    pub fn collision(&self) -> Collision<'_> {
        Collision {
            release: -self.amplitude,
            barrier: self.barrier,
            stiffness: self.stiffness,
            restoring_force: self.restoring_force,
            elastic_force: self.elastic_force,
            damping: 0.0,
            dashpot: None,
        }
    }
}

impl ThreePhases {
    /// The motion in another coordinate, offset + sign x; a cosine oscillates about zero and has no
    /// offset.
    pub(super) fn moved(&self, sign: f64, offset: f64) -> Self {
        Self {
            phases: self
                .phases
                .each_ref()
                .map(|phase| MotionPhase { form: phase.form.moved(sign, offset), ..*phase }),
            ..self.clone()
        }
    }

    /// Time to contact, speed, penetration, duration, period: the numbers that are judged.
    pub fn quantities(&self) -> [f64; 5] {
        [self.phases[0].end, self.speed, self.penetration, self.duration, self.period]
    }

    /// Displacement at this time; the motion repeats with its period, but one that has lost energy
    /// goes on as its return.
    pub fn position_at(&self, time: f64) -> f64 {
        self.phase_point_at(time).0
    }

    /// Velocity at this time, as for [`ThreePhases::position_at`].
    pub fn velocity_at(&self, time: f64) -> f64 {
        self.phase_point_at(time).1
    }

    fn phase_point_at(&self, time: f64) -> (f64, f64) {
        let repeats = self.exit_speed == self.speed;
        let time = if (0.0..=self.period).contains(&time) || !repeats {
            time
        } else {
            time.rem_euclid(self.period)
        };
        let [approach, contact, back] = &self.phases;
        let phase = if time < approach.end {
            approach
        } else if time < contact.end {
            contact
        } else {
            back
        };
        phase.phase_point_at(time)
    }
}

impl MotionPhase {
    /// The number of the join from which its time is counted: contact from t1, the paper's return
    /// from t2, a derived one from t3, its end.
    pub fn joined_at(&self) -> Option<u8> {
        match self.name {
            "contact" => Some(1),
            "return" if self.clock == self.end => Some(3),
            "return" => Some(2),
            _ => None,
        }
    }

    /// Displacement and velocity at this time since the release.
    pub fn phase_point_at(&self, time: f64) -> (f64, f64) {
        self.form.phase_point_at(time - self.clock)
    }

    /// The formula in the usual form, six significant digits (nine for the centre of the contact,
    /// so that the depth has six), without terms too small to write ([`Form::felt_terms`]): t1 is
    /// the start of the contact, t2 its end, t3 that of the return.
    pub fn closed_form(&self) -> String {
        self.closed_form_of(Symbol::new("x"))
    }

    /// The closed form with another symbol for the coordinate.
    pub fn closed_form_of(&self, coordinate: Symbol) -> String {
        let clock = match self.joined_at() {
            Some(join) => format!("(t - t{join})"),
            None => "t".to_owned(),
        };
        match &self.form {
            &Form::Cosine { amplitude, frequency, phase } => {
                let shift = if phase == 0.0 { String::new() } else { signed_term(phase, 6) };
                format!(
                    "{coordinate}(t) = {} cos({} {clock}{shift})",
                    significant(amplitude, 6),
                    significant(frequency, 6)
                )
            }
            &Form::Oscillation { centre, amplitude, frequency } => {
                let frequency = significant(frequency, 6);
                format!(
                    "{coordinate}(t) = {}{} cos({frequency} {clock}){} sin({frequency} {clock})",
                    significant(centre, 9),
                    signed_term(amplitude.re, 6),
                    signed_term(-amplitude.im, 6)
                )
            }
            Form::Harmonics { .. } | Form::Contact { .. } => {
                let written =
                    self.form.felt_terms().into_iter().map(|(function, value)| match function {
                        TimeFunction::Constant => significant(value, 9),
                        TimeFunction::Parabola => {
                            format!("{} {clock} (t2 - t)", significant(value, 6))
                        }
                        TimeFunction::Wave { function, frequency } => format!(
                            "{} {function}({} {clock})",
                            significant(value, 6),
                            significant(frequency, 6)
                        ),
                    });
                format!("{coordinate}(t) = {}", terms::sum(written))
            }
        }
    }
}

/// ` + 1.5` or ` - 1.5`.
fn signed_term(value: f64, digits: usize) -> String {
    let sign = if value < 0.0 { '-' } else { '+' };
    format!(" {sign} {}", significant(value.abs(), digits))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::hertz::{StiffnessDesign, elastic_force};
    use crate::numeric::ode::{Event, IntegrationOptions, State, integrate};
    use proptest::prelude::*;

    const FORCE: fn(f64) -> f64 = f64::sin;

    /// The paper's swing, A = 1.5 and x_c = 0.323, at this stiffness.
    fn paper(stiffness: f64) -> ImpactProblem<'static> {
        ImpactProblem {
            amplitude: 1.5,
            barrier: 0.323,
            stiffness,
            frequency_squared: 1.0 - 1.5 * 1.5 / 8.0,
            linear_stiffness: 1.0,
            restoring_force: &FORCE,
            elastic_force: &elastic_force,
            rule: Rule::LeastSquares,
        }
    }

    fn near(value: f64, expected: f64, allowed: f64) {
        assert!((value - expected).abs() <= allowed, "{value} against {expected}");
    }

    #[test]
    fn the_swing_of_the_paper() {
        let motion = three_phases(
            &paper(StiffnessDesign::default().stiffness().unwrap()),
            ContactSpeed::Paper,
        )
        .unwrap();
        let Form::Cosine { frequency, phase, .. } = motion.phases[2].form else {
            panic!("return is a cosine")
        };
        near(frequency, 0.847_791_247_9, 5e-11);
        near(1.5 * frequency, 1.271_686_872, 5e-10);
        near(motion.speed, 1.241_853_869, 5e-10);
        near(motion.phases[0].end, 2.108_808_612, 5e-10);
        near(phase, 1.353_763_169, 5e-10);
        near(motion.fitted.unwrap().depth, 1.3208e-3, 5e-8);
        assert_eq!(motion.velocity_jump, 0.0);
    }

    #[test]
    fn the_energy_column_has_the_exact_speed_and_prints_the_jump() {
        let motion = three_phases(&paper(3.0407e7), ContactSpeed::Energy).unwrap();
        near(motion.speed, (2.0 * (0.323_f64.cos() - 1.5_f64.cos())).sqrt(), 1e-14);
        near(motion.speed, 1.324_802_058_11, 5e-12);
        near(motion.velocity_jump, 1.324_802_058_11 - 1.241_853_869, 1e-9);
        near(motion.fitted.unwrap().depth, 1.3909e-3, 5e-8);
        // The cubic restoring force of equation (11).
        near(
            ImpactProblem { restoring_force: &|x| x - x * x * x / 6.0, ..paper(3.0407e7) }
                .collision()
                .contact_speed()
                .unwrap(),
            1.313_279_499_96,
            5e-12,
        );
    }

    #[test]
    fn every_join_is_continuous_in_the_papers_column() {
        for (barrier, stiffness) in
            [(0.323, 3.0407e7), (0.0, 1e6), (-0.9, 1e4), (1.4, 1e9), (0.323, 1.0)]
        {
            let motion =
                three_phases(&ImpactProblem { barrier, ..paper(stiffness) }, ContactSpeed::Paper)
                    .unwrap();
            let [approach, contact, back] = &motion.phases;
            for (left, right) in [(approach, contact), (contact, back)] {
                let before = left.form.phase_point_at(left.end - left.start);
                let after = right.form.phase_point_at(0.0);
                near(before.0, barrier, 1e-14);
                near(after.0, barrier, 1e-14);
                near(before.1, after.1, 2e-12);
            }
            near(back.form.phase_point_at(0.0).1, -motion.speed, 1e-14);
            near(back.form.phase_point_at(back.end - back.start).0, -1.5, 1e-14);
            near(back.form.phase_point_at(back.end - back.start).1, 0.0, 1e-14);
            near(motion.period, 2.0 * approach.end + motion.duration, 1e-14);
        }
    }

    #[test]
    fn the_contact_solves_equation_15() {
        for (barrier, stiffness, rule) in [
            (0.323, 1e6, Rule::LeastSquares),
            (-0.5, 1e3, Rule::EqualEnergy),
            (0.9, 30.0, Rule::LeastSquares),
        ] {
            let swing = ImpactProblem { barrier, rule, ..paper(stiffness) };
            let motion = three_phases(&swing, ContactSpeed::Energy).unwrap();
            let (p, q) =
                (motion.fitted.unwrap().line.slope, motion.fitted.unwrap().line.q(barrier));
            let contact = &motion.phases[1];
            let options = IntegrationOptions::with_tolerance(1e-13);
            let start = State { t: contact.start, x: barrier, v: motion.speed };
            let events = [
                Event::record(|_, _, v| v).falling(),
                Event::stop(move |_, x, _| x - barrier).falling(),
            ];
            let path =
                integrate(|_, x, _| -x - stiffness * (p * x - q), start, 10.0, &events, &options)
                    .unwrap();
            near(path.end().t, contact.end, 1e-10);
            near(path.end().v, -motion.speed, 1e-10);
            near(path.occurrences()[0].state.x - barrier, motion.penetration, 1e-11);
            for state in path.samples(50) {
                let (x, v) = contact.form.phase_point_at(state.t - contact.start);
                near(x, state.x, 1e-11);
                near(v, state.v, 1e-8);
            }
        }
    }

    #[test]
    fn the_error_of_each_line_in_duration_and_depth() {
        // Against Hertz's own contact, gravity left out: the table of errors in percent, to its
        // printed digits.
        let speed = 1.3;
        let table = [
            (Rule::LeastSquares, 1.6, 0.0),
            (Rule::LeastSquaresThroughTouch, 3.1, -3.4),
            (Rule::EqualEnergy, 6.7, 0.0),
            (Rule::EqualPeak, -4.5, -10.6),
            (Rule::HarmonicBalance, -0.21, -6.5),
            (Rule::EqualDuration, 0.0, -6.3),
        ];
        for (rule, duration_error, depth_error) in table {
            let depth = crate::impact::hertz::penetration(1e6, speed).unwrap();
            let line = linearisation::fit(rule, elastic_force, depth).unwrap();
            let contact = LineContact::new(line, 1e6, [0.0; 2], speed).unwrap();
            let duration = crate::impact::hertz::duration(1e6, speed).unwrap();
            near(100.0 * (contact.duration() / duration - 1.0), duration_error, 0.06);
            near(100.0 * (contact.depth() / depth - 1.0), depth_error, 0.06);
        }
    }

    #[test]
    fn the_formulas_as_people_write_them() {
        let motion = three_phases(&paper(3.0407e7), ContactSpeed::Paper).unwrap();
        assert_eq!(motion.phases[0].closed_form(), "x(t) = -1.5 cos(0.847791 t)");
        assert_eq!(motion.phases[2].closed_form(), "x(t) = 1.5 cos(0.847791 (t - t2) + 1.35376)");
        let contact = motion.phases[1].closed_form();
        assert!(
            contact.starts_with("x(t) = 0.323")
                && contact.contains(" sin(")
                && contact.contains("(t - t1)")
        );
    }

    #[test]
    fn the_formula_text_carries_the_motion() {
        let motion = three_phases(&paper(3.0407e7), ContactSpeed::Energy).unwrap();
        let contact = &motion.phases[1];
        // centre + c cos + s sin read back from the text.
        let numbers: Vec<f64> = contact
            .closed_form()
            .replace(" - ", " + -")
            .split(|c: char| !(c.is_ascii_digit() || "-.e".contains(c)))
            .filter_map(|word| word.parse().ok())
            .filter(|number: &f64| *number != 1.0)
            .collect();
        let middle = 0.5 * (contact.end - contact.start);
        let (centre, cosine, frequency, sine) = (numbers[0], numbers[1], numbers[2], numbers[3]);
        let x = centre + cosine * (frequency * middle).cos() + sine * (frequency * middle).sin();
        near(x, contact.form.phase_point_at(middle).0, 2e-8);
    }

    #[test]
    fn what_cannot_be_is_refused_with_a_way_on() {
        let refuse = |swing: ImpactProblem| three_phases(&swing, ContactSpeed::Energy).unwrap_err();
        let usual = paper(1e6);
        for barrier in [1.5, 2.0] {
            let refused = refuse(ImpactProblem { barrier, ..usual });
            assert!(
                refused.to_string().starts_with("the pendulum never reaches the barrier"),
                "{refused}"
            );
        }
        assert!(matches!(
            refuse(ImpactProblem { barrier: -1.5, ..usual }),
            ImpactError::Collision(CollisionError::ReleasedBehindBarrier { .. })
        ));
        assert!(matches!(
            refuse(ImpactProblem { barrier: f64::NAN, ..usual }),
            ImpactError::Collision(CollisionError::Barrier(_))
        ));
        for stiffness in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                refuse(ImpactProblem { stiffness, ..usual }),
                ImpactError::Collision(CollisionError::Stiffness(_))
            ));
        }
        for amplitude in [0.0, -1.5, f64::INFINITY] {
            assert!(matches!(
                refuse(ImpactProblem { amplitude, ..usual }),
                ImpactError::Collision(CollisionError::Amplitude(_))
            ));
        }
        let beyond =
            refuse(ImpactProblem { amplitude: 3.0, frequency_squared: 1.0 - 9.0 / 8.0, ..usual });
        assert!(beyond.to_string().contains("omega^2 = -0.125 at A = 3"), "{beyond}");
        for amplitude in [std::f64::consts::PI, 3.5] {
            let outside = refuse(ImpactProblem { amplitude, ..usual });
            assert!(
                matches!(outside, ImpactError::Collision(CollisionError::OutsideTheWell { .. })),
                "{outside}"
            );
        }
        // A hill on the way: V = cos(3 x)-like, higher in the middle than at the release.
        let hill = |x: f64| -(3.0 * x).sin();
        let outside = refuse(ImpactProblem { restoring_force: &hill, amplitude: 0.9, ..usual });
        assert!(
            matches!(outside, ImpactError::Collision(CollisionError::OutsideTheWell { .. })),
            "{outside}"
        );
    }

    #[test]
    fn a_vanishing_stiffness_leads_to_the_linear_free_swing() {
        // x'' + x = 0 from x_c with speed v: back after 2 atan2(v, x_c).
        let motion = three_phases(&paper(1e-9), ContactSpeed::Paper).unwrap();
        near(motion.duration, 2.0 * motion.speed.atan2(0.323), 1e-3);
    }

    proptest! {
        #[test]
        fn energy_is_kept_within_each_phase(
            amplitude in 0.1..2.5_f64, part in -0.9..0.9_f64, gamma_power in 0.0..10.0_f64, time in 0.0..1.0_f64
        ) {
            let swing = ImpactProblem {
                amplitude,
                barrier: part * amplitude,
                frequency_squared: 1.0 - amplitude * amplitude / 8.0,
                ..paper(10.0_f64.powf(gamma_power))
            };
            let motion = three_phases(&swing, ContactSpeed::Paper).unwrap();
            prop_assert!(motion.penetration > 0.0 && motion.duration > 0.0);
            for phase in &motion.phases {
                let elapsed = time * (phase.end - phase.start);
                let (x, v) = phase.form.phase_point_at(elapsed);
                let (stiffness, centre) = match phase.form {
                    Form::Cosine { frequency, .. } => (frequency * frequency, 0.0),
                    Form::Oscillation { frequency, centre, .. } => (frequency * frequency, centre),
                    Form::Harmonics { .. } | Form::Contact { .. } => panic!("one wave a phase"),
                };
                let energy = |x: f64, v: f64| v * v + stiffness * (x - centre).powi(2);
                let (x0, v0) = phase.form.phase_point_at(0.0);
                prop_assert!((energy(x, v) / energy(x0, v0) - 1.0).abs() < 1e-9);
            }
        }
    }
}

//! The problem file as a motion of the damper: equation (7), its start, and how closely to follow it.

use thiserror::Error;

use super::keys::key_of;
use super::{Barrier, Problem, ProblemError, Reader, UnreadKey};
use crate::impact::{Friction, Model, ModelError, Settings, Side, Start};
use crate::spelling::nearest;

/// What a problem file says about the damper.
#[derive(Clone, Debug, PartialEq)]
pub struct Damper {
    /// The equation.
    pub model: Model,
    /// The start.
    pub start: Start,
    /// Duration and accuracy.
    pub options: Settings,
    /// Where gamma comes from.
    pub gamma_source: &'static str,
    /// Where mu comes from.
    pub mu_source: &'static str,
}

/// Why a problem file is no motion of the damper.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum DamperError {
    /// The file itself, or its design.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// The model or its start.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// An equation of its own.
    #[error("simulate follows the paper's equation (7): leave out `equation`, or use `lindstedt derive`")]
    Equation,
    /// A release that is none.
    #[error("[pendulum] amplitude must be a positive number, not {0}; for another start give `start` and `speed`")]
    Amplitude(f64),
    /// A release behind a barrier, which is no release.
    #[error(
        "the motion starts at x = {start}, inside the {} barrier at {barrier}: move the barrier, or give `start` in \
         [pendulum]", .side.name()
    )]
    Inside {
        /// Which barrier.
        side: Side,
        /// Its position, rad.
        barrier: f64,
        /// The start, rad.
        start: f64,
    },
    /// A key that another one leaves nothing to say.
    #[error("`{key}` changes nothing where `{other}` is given: leave one of them out")]
    NoEffect {
        /// The key.
        key: &'static str,
        /// The other one.
        other: &'static str,
    },
    /// A key that says something only beside another one.
    #[error("`{key}` changes nothing without `{other}`: give that too, or leave it out")]
    Alone {
        /// The key.
        key: &'static str,
        /// The other one.
        other: &'static str,
    },
    /// A key that belongs to another command.
    #[error(transparent)]
    Unread(#[from] UnreadKey),
    /// Two dampings of the contact.
    #[error("[contact] has both mu and lambda: mu = gamma*lambda*sqrt(g*L), give one of them")]
    TwoDampings,
    /// A contact damping that makes no number.
    #[error("[contact] lambda = {0} makes no finite mu: it is in s/m, some hundredths for a hard material")]
    Lambda(f64),
    /// An unknown law of friction.
    #[error("[damping] friction `{0}` is neither \"exact\" nor \"arctangent\"")]
    Friction(String),
    /// An excitation without a frequency.
    #[error("[excitation] beta = {0} needs a frequency_ratio above 0: a pivot that stands still excites nothing")]
    NoFrequency(f64),
    /// A tolerance that cannot be kept.
    #[error("[run] integrator_tolerance must lie between 1e-15 and 0.01, not {0:e}: 1e-10 is a good choice")]
    Tolerance(f64),
    /// A limit that nothing or too much fits into: every step of a motion is kept.
    #[error("[run] step_limit must be a whole number from 1 to {MOST_STEPS}, not {0}")]
    StepLimit(u32),
    /// A duration that is none.
    #[error("[run] duration must be a positive number, not {0}")]
    Duration(f64),
    /// A parameter of a sweep that does not exist.
    #[error("there is no parameter `{name}` to sweep: choose one of {}", PARAMETERS.join(", "))]
    Parameter {
        /// What was asked for.
        name: String,
        /// What was meant, perhaps.
        nearest: Option<&'static str>,
    },
}

impl DamperError {
    /// What to write instead, where it is known.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Problem(error) => error.help(),
            Self::Parameter {
                nearest: Some(name), ..
            } => Some(format!("did you mean `{name}`?")),
            _ => None,
        }
    }
}

/// The most steps a run may be given: some gigabytes of power series.
pub const MOST_STEPS: u32 = 10_000_000;

/// The parameters that a sweep may vary.
pub const PARAMETERS: [&str; 17] = [
    "amplitude",
    "start",
    "speed",
    "barrier",
    "gamma",
    "mu",
    "lambda",
    "zeta",
    "alpha",
    "beta",
    "frequency_ratio",
    "mass",
    "radius",
    "length",
    "modulus",
    "gravity",
    "duration",
];

impl Problem {
    /// The motion of the damper that this file describes.
    ///
    /// # Errors
    /// [`DamperError`] names the section and the key.
    pub fn damper(&self) -> Result<Damper, DamperError> {
        if self.equation.is_some() {
            return Err(DamperError::Equation);
        }
        self.check_keys(Reader::Simulate)?;
        let amplitude = self.pendulum.amplitude;
        let x = match self.pendulum.start {
            Some(start) => start,
            None if amplitude > 0.0 && amplitude.is_finite() => -amplitude,
            None => return Err(DamperError::Amplitude(amplitude)),
        };
        let start = Start {
            x,
            velocity: self.pendulum.speed.unwrap_or(0.0),
        };
        let (left, right) = match self.pendulum.barrier {
            Barrier::Right(right) => (None, Some(right)),
            Barrier::Both([left, right]) => (Some(left), Some(right)),
        };
        let (gamma, gamma_source) = self.stiffness()?;
        let (mu, mu_source) = match (self.contact.mu, self.contact.lambda) {
            (Some(_), Some(_)) => return Err(DamperError::TwoDampings),
            (Some(mu), None) => (mu, "given"),
            (None, Some(lambda)) => {
                let mu = gamma * lambda * (self.design.gravity * self.design.length).sqrt();
                if !mu.is_finite() {
                    return Err(DamperError::Lambda(lambda));
                }
                (mu, "gamma*lambda*sqrt(g*L)")
            }
            (None, None) => (0.0, "default"),
        };
        let friction = match self.damping.friction.as_deref() {
            None | Some("exact") => Friction::Exact,
            Some("arctangent") => Friction::Arctangent,
            Some(other) => return Err(DamperError::Friction(other.to_owned())),
        };
        let super::Excitation { beta, frequency_ratio } = self.excitation;
        if beta != 0.0 && frequency_ratio == 0.0 {
            return Err(DamperError::NoFrequency(beta));
        }
        let model = Model {
            zeta: self.damping.zeta,
            alpha: self.damping.alpha,
            friction,
            beta,
            frequency_ratio,
            gamma,
            mu,
            left,
            right,
        };
        model.check(start)?;
        if self.pendulum.start.is_none()
            && let Some((side, _)) = model.depth(start.x)
        {
            return Err(DamperError::Inside {
                side,
                barrier: model.barrier(side).unwrap_or_default(),
                start: start.x,
            });
        }
        let tolerance = self.run.integrator_tolerance;
        if !(1e-15..=0.01).contains(&tolerance) {
            return Err(DamperError::Tolerance(tolerance));
        }
        if !(1..=MOST_STEPS).contains(&self.run.step_limit) {
            return Err(DamperError::StepLimit(self.run.step_limit));
        }
        let duration = self.run.duration;
        if !(duration > 0.0 && duration.is_finite()) {
            return Err(DamperError::Duration(duration));
        }
        let (amplitude, start_key) = ("[pendulum] amplitude", "[pendulum] start");
        if self.gives(amplitude) && self.gives(start_key) {
            return Err(DamperError::NoEffect {
                key: amplitude,
                other: start_key,
            });
        }
        for (key, other) in [
            ("[excitation] frequency_ratio", "[excitation] beta"),
            ("[damping] friction", "[damping] alpha"),
        ] {
            if self.gives(key) && !self.gives(other) {
                return Err(DamperError::Alone { key, other });
            }
        }
        let options = Settings {
            duration,
            // The errors of some hundred steps add up, and impacts multiply them.
            relative_tolerance: (1e-2 * tolerance).max(1e-15),
            absolute_tolerance: 1e-4 * tolerance,
            maximum_steps: self.run.step_limit as usize,
            ..Settings::default()
        };
        Ok(Damper {
            model,
            start,
            options,
            gamma_source,
            mu_source,
        })
    }

    /// Gives a parameter another value, by the name of its key.
    ///
    /// # Errors
    /// [`DamperError::Parameter`] where there is none of that name, [`DamperError::NoEffect`] where another key leaves it
    /// nothing to say.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), DamperError> {
        if let Some(key) = key_of(name) {
            if self.unused_design().contains(&name) {
                let other = "[contact] gamma";
                return Err(DamperError::NoEffect { key, other });
            }
            if !self.gives(key) {
                self.given.push(key.to_owned());
            }
        }
        match name {
            "amplitude" => self.pendulum.amplitude = value,
            "start" => self.pendulum.start = Some(value),
            "speed" => self.pendulum.speed = Some(value),
            "barrier" => {
                self.pendulum.barrier = match self.pendulum.barrier {
                    Barrier::Right(_) => Barrier::Right(value),
                    Barrier::Both([left, _]) => Barrier::Both([left, value]),
                }
            }
            "gamma" => self.contact.gamma = Some(value),
            "mu" => self.contact.mu = Some(value),
            "lambda" => self.contact.lambda = Some(value),
            "zeta" => self.damping.zeta = value,
            "alpha" => self.damping.alpha = value,
            "beta" => self.excitation.beta = value,
            "frequency_ratio" => self.excitation.frequency_ratio = value,
            "mass" => self.design.mass = value,
            "radius" => self.design.radius = value,
            "length" => self.design.length = value,
            "modulus" => self.design.modulus = value,
            "gravity" => self.design.gravity = value,
            "duration" => self.run.duration = value,
            _ => {
                return Err(DamperError::Parameter {
                    name: name.to_owned(),
                    nearest: nearest(name, PARAMETERS),
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lambda_is_a_material_and_mu_follows_from_it() {
        let problem: Problem = "[contact]\ngamma = 1e6\nlambda = 0.1\n[design]\nlength = 0.25\ngravity = 9.0"
            .parse()
            .unwrap();
        assert!((problem.damper().unwrap().model.mu / 1.5e5 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn the_release_is_from_rest_unless_the_file_says_otherwise() {
        let start = |text: &str| text.parse::<Problem>().unwrap().damper().unwrap().start;
        assert_eq!(start(""), Start { x: -1.5, velocity: 0.0 });
        assert_eq!(
            start("[pendulum]\nstart = 0.1\nspeed = -2"),
            Start { x: 0.1, velocity: -2.0 }
        );
    }

    #[test]
    fn every_parameter_named_can_be_set() {
        for name in PARAMETERS {
            assert!(Problem::default().set(name, 0.5).is_ok(), "{name}");
        }
        let error = Problem::default().set("zetta", 0.5).unwrap_err();
        assert_eq!(error.help().as_deref(), Some("did you mean `zeta`?"));
    }
}

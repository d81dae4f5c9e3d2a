//! What `simulate` reads of a problem file: a case of equation (7), and how closely to follow it.

use thiserror::Error;

use super::{Barrier, BarrierSide, Problem, ProblemError, Reader, UnreadKey};
use crate::impact::{Case, CaseError, ContactDamping, Friction, Parameter, Settings, Side, Units};

/// What a problem file says of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulate {
    /// The pendulum, its barrier, its start.
    pub case: Case,
    /// Duration and accuracy.
    pub settings: Settings,
    /// Whether the file says for how long.
    pub duration_given: bool,
    /// Where gamma comes from.
    pub gamma_source: &'static str,
    /// Where mu comes from.
    pub mu_source: &'static str,
    /// The pendulum in SI units, where they are known.
    pub units: Option<Units>,
}

/// Why a problem file is no motion.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SimulateError {
    /// The file itself.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// The numbers of the pendulum and its barrier.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// An equation of its own.
    #[error(
        "simulate follows the paper's equation (7): leave out `equation`, or use `lindstedt derive`"
    )]
    Equation,
    /// A key that another one leaves nothing to say.
    #[error("`{key}` changes nothing where `{other}` is given: leave one of them out")]
    NoEffect {
        /// The key.
        key: Parameter,
        /// The other one.
        other: Parameter,
    },
    /// A number of a barrier that is not there.
    #[error("`{0}` changes nothing where `[pendulum] barrier = false`: leave one of them out")]
    NoBarrier(Parameter),
    /// A side of which nothing is: neither the only barrier nor the release.
    #[error("`[pendulum] side` changes nothing beside {0} and a start: leave it out")]
    Side(&'static str),
    /// A modulus that is not that of one body.
    #[error(
        "`modulus` is that of the barrier alone, and `{0}` makes it that of two bodies: leave out one of them"
    )]
    ModulusOfTwo(&'static str),
    /// A number that zero leaves nothing to say.
    #[error(
        "`{key}` changes nothing where `{other}` is 0: give it another value, or leave `{key}` out"
    )]
    Zero {
        /// The key.
        key: Parameter,
        /// The other one.
        other: Parameter,
    },
    /// A key that says something only beside another one.
    #[error("`{key}` changes nothing without `{other}`: give that too, or leave it out")]
    Alone {
        /// The key.
        key: &'static str,
        /// The other one.
        other: Parameter,
    },
    /// A key that belongs to another command.
    #[error(transparent)]
    Unread(#[from] UnreadKey),
    /// The same by two keys.
    #[error("`{key}` and `{other}` say the same: give one of them, which is then held fixed")]
    Twice {
        /// The key.
        key: Parameter,
        /// The other one.
        other: Parameter,
    },
    /// An unknown law of friction.
    #[error("[damping] friction `{0}` is neither \"exact\" nor \"arctangent\"")]
    Friction(String),
    /// A tolerance that cannot be kept.
    #[error(
        "[run] integrator_tolerance must lie between 1e-15 and 0.01, not {0:e}: 1e-10 is a good choice"
    )]
    Tolerance(f64),
    /// A limit that nothing or too much fits into: every step of a motion is kept.
    #[error("[run] step_limit must be a whole number from 1 to {MOST_STEPS}, not {0}")]
    StepLimit(u32),
    /// A duration that is none.
    #[error("[run] duration must be a positive number, not {0}")]
    Duration(f64),
}

impl SimulateError {
    /// What to write instead, where it is known.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Problem(error) => error.help(),
            _ => None,
        }
    }
}

/// The most steps a run may be given: some gigabytes of power series.
pub const MOST_STEPS: u32 = 10_000_000;

impl TryFrom<&Problem> for Simulate {
    type Error = SimulateError;

    /// ```
    /// use lindstedt::impact::{Integrator, simulate};
    /// use lindstedt::problem::{Problem, Simulate};
    ///
    /// let file: Problem = "[damping]\nzeta = 0.02\n[run]\nduration = 10".parse()?;
    /// let Simulate { case, settings, .. } = Simulate::try_from(&file)?;
    /// let (model, start) = case.motion()?;
    /// let motion = simulate(&model, start, Integrator::Taylor, &settings)?;
    /// assert_eq!(motion.impacts.len(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn try_from(problem: &Problem) -> Result<Self, SimulateError> {
        let asked = problem.simulate(&[])?;
        // A case of its own must make a motion; where parameters are swept, their values are still
        // to come.
        asked.case.motion()?;
        Ok(asked)
    }
}

impl Problem {
    /// What this file says of motions whose `swept` parameters get other values later, as if it
    /// gave them too.
    ///
    /// # Errors
    /// [`SimulateError`] names the section and the key. Whether the numbers make a motion is seen
    /// by [`Case::motion`].
    ///
    /// ```
    /// use lindstedt::{impact::Parameter, problem::Problem};
    ///
    /// let file: Problem = "[run]\nduration = 10".parse()?;
    /// let asked = file.simulate(&[Parameter::Barrier])?;
    /// assert_eq!(asked.settings.duration, 10.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn simulate(&self, swept: &[Parameter]) -> Result<Simulate, SimulateError> {
        let gives =
            |parameter: Parameter| swept.contains(&parameter) || self.gives_parameter(parameter);
        self.check_swept(swept, gives)?;
        if self.equation.is_some() {
            return Err(SimulateError::Equation);
        }
        self.check_keys(Reader::Simulate)?;
        refuse_two_forms(gives)?;
        let mut case = self.case()?;
        case.speed_unit = self.speed_unit(swept);
        let settings = self.settings()?;
        self.check_side(swept)?;
        self.check_pairs(gives)?;
        Ok(Simulate {
            settings,
            duration_given: self.gives("[run] duration"),
            gamma_source: self.stiffness_source(&case.design),
            mu_source: match case.contact_damping {
                _ if !ContactDamping::FORMS.into_iter().any(gives) => "default",
                ContactDamping::Mu(_) => "given",
                ContactDamping::MuOverGamma(_) => "gamma*mu_over_gamma",
                ContactDamping::Lambda(_) => "gamma*lambda*sqrt(g*L)",
                ContactDamping::Restitution(_) if case.at_speed.is_some() => {
                    "for the restitution at at_speed"
                }
                ContactDamping::Restitution(_) => {
                    "for the restitution at the first touch without damping"
                }
                ContactDamping::Coefficient(_) => "damping*L^2/(m*sqrt(g))",
            },
            units: self.simulation_units(&case.design),
            case,
        })
    }

    /// Whether a file, or whoever made this problem, gives a parameter.
    pub(super) fn gives_parameter(&self, parameter: Parameter) -> bool {
        let (contact, damping) = (&self.contact, &self.damping);
        match parameter {
            Parameter::Gamma => contact.gamma.is_some(),
            Parameter::Mu => contact.mu.is_some(),
            Parameter::MuOverGamma => contact.mu_over_gamma.is_some(),
            Parameter::Lambda => contact.lambda.is_some(),
            Parameter::Restitution => contact.restitution.is_some(),
            Parameter::AtSpeed => contact.at_speed.is_some(),
            Parameter::ContactDamping => contact.damping.is_some(),
            Parameter::Viscous => damping.viscous.is_some(),
            Parameter::Torque => damping.torque.is_some(),
            _ => self.gives(&parameter.to_string()),
        }
    }

    /// The numbers of the pendulum and its barrier, as they are given.
    pub(super) fn case(&self) -> Result<Case, SimulateError> {
        let side = match self.pendulum.side {
            Some(BarrierSide::Left) => Side::Left,
            Some(BarrierSide::Right) | None => Side::Right,
        };
        let (left, right) = match (self.pendulum.barrier, side) {
            (Barrier::Absent(_), _) => (None, None),
            (Barrier::One(place), Side::Left) => (Some(place), None),
            (Barrier::One(place), Side::Right) => (None, Some(place)),
            (Barrier::Both([left, right]), _) => (Some(left), Some(right)),
        };
        let friction = match self.damping.friction.as_deref() {
            None | Some("exact") => Friction::Exact,
            Some("arctangent") => Friction::Arctangent,
            Some(other) => return Err(SimulateError::Friction(other.to_owned())),
        };
        Ok(Case {
            amplitude: self.pendulum.amplitude,
            side,
            start: self.pendulum.start,
            speed: self.pendulum.speed.unwrap_or(0.0),
            left,
            right,
            gamma: self.contact.gamma,
            contact_damping: self.contact.given_damping().unwrap_or(ContactDamping::Mu(0.0)),
            at_speed: self.contact.at_speed,
            speed_unit: self.speed_unit(&[]),
            zeta: self.damping.zeta,
            viscous: self.damping.viscous,
            alpha: self.damping.alpha,
            torque: self.damping.torque,
            friction,
            beta: self.excitation.beta,
            frequency_ratio: self.excitation.frequency_ratio,
            design: self.design().map_err(ProblemError::from)?,
        })
    }

    /// `[run]`
    pub(super) fn settings(&self) -> Result<Settings, SimulateError> {
        let tolerance = self.run.integrator_tolerance;
        if !(1e-15..=0.01).contains(&tolerance) {
            return Err(SimulateError::Tolerance(tolerance));
        }
        if !(1..=MOST_STEPS).contains(&self.run.step_limit) {
            return Err(SimulateError::StepLimit(self.run.step_limit));
        }
        let duration = self.run.duration;
        if !(duration > 0.0 && duration.is_finite()) {
            return Err(SimulateError::Duration(duration));
        }
        Ok(Settings {
            duration,
            // The errors of some hundred steps add up, and impacts multiply them.
            relative_tolerance: (1e-2 * tolerance).max(1e-15),
            absolute_tolerance: 1e-4 * tolerance,
            maximum_steps: self.run.step_limit as usize,
            ..Settings::default()
        })
    }

    /// Refuses to sweep what changes nothing: for want of a barrier, because gamma is given, or
    /// swept as well, or beside a zero.
    fn check_swept(
        &self,
        swept: &[Parameter],
        gives: impl Fn(Parameter) -> bool,
    ) -> Result<(), SimulateError> {
        use Parameter::{
            AtSpeed, Barrier as Place, Beta, ContactDamping as Coefficient, FrequencyRatio, Gamma,
            Gravity, Lambda, Length, Mass, Modulus, Mu, MuOverGamma, Radius, Restitution, Torque,
            Viscous,
        };
        let zero = |key: Parameter, given: Option<f64>| {
            !swept.contains(&key) && given.unwrap_or(0.0) == 0.0
        };
        // c = 2*zeta*m*omega, torque = alpha*m*g*L; a main mass is measured in those of the
        // pendulum.
        let swing_in_si = !zero(Viscous, self.damping.viscous)
            || !zero(Torque, self.damping.torque)
            || self.primary.is_some();
        // c = mu*m*sqrt(g)/L^2
        let in_si = swing_in_si || !zero(Coefficient, self.contact.damping);
        let at_speed_in_si = self.contact.at_speed.is_some() || swept.contains(&AtSpeed);
        let of_contact = |key: &Parameter| match key {
            Gamma | Mu | MuOverGamma | Lambda | Restitution | AtSpeed | Coefficient | Radius
            | Modulus => true,
            Mass | Length | Gravity => !swing_in_si,
            _ => false,
        };
        if matches!(self.pendulum.barrier, Barrier::Absent(_)) && !swept.contains(&Place) {
            let first = swept.iter().copied().find(of_contact);
            first.map_or(Ok(()), |key| Err(SimulateError::NoBarrier(key)))?;
        }
        if self.contact.gamma == Some(0.0) && !swept.contains(&Gamma) {
            let first = swept.iter().copied().find(|key| *key == Place || of_contact(key));
            first.map_or(Ok(()), |key| Err(SimulateError::Zero { key, other: Gamma }))?;
        }
        if swept.contains(&FrequencyRatio) && gives(Beta) && zero(Beta, Some(self.excitation.beta))
        {
            return Err(SimulateError::Zero { key: FrequencyRatio, other: Beta });
        }
        let of_two = [
            ("[sphere] modulus", self.sphere.modulus.is_some()),
            ("[barrier] poisson", self.barrier.poisson.is_some()),
        ];
        if let (true, Some((key, _))) =
            (swept.contains(&Modulus), of_two.into_iter().find(|(_, given)| *given))
        {
            return Err(SimulateError::ModulusOfTwo(key));
        }
        let without_loss = self.contact.restitution == Some(1.0) && !swept.contains(&Restitution);
        if swept.contains(&AtSpeed) && without_loss {
            return Err(SimulateError::NoEffect { key: AtSpeed, other: Restitution });
        }
        let without_say = |parameter: &Parameter| match parameter {
            Radius | Modulus => true,
            Mass => !in_si,
            // mu = gamma*lambda*sqrt(g*L), and v/sqrt(g*L) for a speed in m/s
            Length | Gravity => !in_si && !at_speed_in_si && zero(Lambda, self.contact.lambda),
            _ => false,
        };
        match swept.iter().copied().find(without_say).filter(|_| gives(Gamma)) {
            Some(key) => Err(SimulateError::NoEffect { key, other: Gamma }),
            None => Ok(()),
        }
    }

    /// Refuses a side that says nothing: of a barrier there is or is swept, or of the release.
    fn check_side(&self, swept: &[Parameter]) -> Result<(), SimulateError> {
        let starts = self.pendulum.start.is_some() || swept.contains(&Parameter::Start);
        if self.pendulum.side.is_none() || !starts || swept.contains(&Parameter::Barrier) {
            return Ok(());
        }
        match self.pendulum.barrier {
            Barrier::Absent(_) => Err(SimulateError::Side("no barrier")),
            Barrier::Both(_) => Err(SimulateError::Side("two barriers")),
            Barrier::One(_) => Ok(()),
        }
    }

    /// Refuses a key that another one leaves nothing to say, or that says nothing alone.
    pub(super) fn check_pairs(
        &self,
        gives: impl Fn(Parameter) -> bool,
    ) -> Result<(), SimulateError> {
        let (key, other) = (Parameter::Amplitude, Parameter::Start);
        if gives(key) && gives(other) {
            return Err(SimulateError::NoEffect { key, other });
        }
        if gives(Parameter::FrequencyRatio) && !gives(Parameter::Beta) {
            return Err(SimulateError::Alone {
                key: "[excitation] frequency_ratio",
                other: Parameter::Beta,
            });
        }
        if gives(Parameter::AtSpeed) && !gives(Parameter::Restitution) {
            return Err(SimulateError::Alone {
                key: "[contact] at_speed",
                other: Parameter::Restitution,
            });
        }
        let friction = "[damping] friction";
        if self.gives(friction) && !gives(Parameter::Alpha) && !gives(Parameter::Torque) {
            return Err(SimulateError::Alone { key: friction, other: Parameter::Alpha });
        }
        Ok(())
    }
}

/// Refuses what is given in two forms.
pub(super) fn refuse_two_forms(gives: impl Fn(Parameter) -> bool) -> Result<(), SimulateError> {
    let forms: [&[Parameter]; 3] = [
        &ContactDamping::FORMS,
        &[Parameter::Zeta, Parameter::Viscous],
        &[Parameter::Alpha, Parameter::Torque],
    ];
    for forms in forms {
        let mut given = forms.iter().copied().filter(|form| gives(*form));
        if let (Some(key), Some(other)) = (given.next(), given.next()) {
            return Err(SimulateError::Twice { key, other });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::Start;

    fn asked(text: &str) -> Result<Simulate, SimulateError> {
        Simulate::try_from(&text.parse::<Problem>().unwrap())
    }

    #[test]
    fn lambda_is_a_material_and_mu_follows_from_it() {
        let asked =
            asked("[contact]\ngamma = 1e6\nlambda = 0.1\n[design]\nlength = 0.25\ngravity = 9.0")
                .unwrap();
        assert!((asked.case.motion().unwrap().0.mu / 1.5e5 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn the_release_is_from_rest_unless_the_file_says_otherwise() {
        let start = |text: &str| asked(text).unwrap().case.motion().unwrap().1;
        assert_eq!(start(""), Start::default());
        assert_eq!(start("[pendulum]\nstart = 0.1\nspeed = -2"), Start { x: 0.1, velocity: -2.0 });
    }

    #[test]
    fn what_is_swept_counts_as_given() {
        let sweep =
            |text: &str, swept: &[Parameter]| text.parse::<Problem>().unwrap().simulate(swept);
        assert!(sweep("", &[Parameter::Mass]).is_ok());
        for (text, swept) in [
            ("[contact]\ngamma = 1e6", &[Parameter::Mass][..]),
            ("", &[Parameter::Gamma, Parameter::Length]),
            ("[pendulum]\nstart = 0.1", &[Parameter::Amplitude]),
            ("", &[Parameter::FrequencyRatio]),
            ("[contact]\nmu = 1", &[Parameter::Lambda]),
            ("[contact]\nrestitution = 0.8", &[Parameter::ContactDamping]),
            ("[contact]\nlambda = 0.1", &[Parameter::AtSpeed]),
            ("[damping]\nviscous = 0.1", &[Parameter::Zeta]),
            ("[damping]\nalpha = 0.1", &[Parameter::Torque]),
            ("[contact]\ngamma = 1e6\nmu_over_gamma = 0.1", &[Parameter::Length]),
        ] {
            assert!(sweep(text, swept).is_err(), "{text} {swept:?}");
        }
        assert!(sweep("[excitation]\nbeta = 0.1", &[Parameter::FrequencyRatio]).is_ok());
        let lambda = "[contact]\ngamma = 1e6\nlambda = 0.1";
        assert!(sweep(lambda, &[Parameter::Length]).is_ok());
        assert!(sweep("[contact]\nrestitution = 0.8", &[Parameter::AtSpeed]).is_ok());
        assert!(sweep("[contact]\ngamma = 1e6\ndamping = 10", &[Parameter::Mass]).is_ok());
    }
}

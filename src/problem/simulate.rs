//! The input of `simulate` from a problem file: a case of equation (7), and the accuracy of its
//! integration.

use super::{Barrier, BarrierSide, Problem, ProblemError, ReadingCommand, Run, refused};
use crate::impact::{Case, ContactDamping, Friction, Parameter, Settings, Side, Units};

/// The motion that a problem file describes.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulate {
    /// The pendulum, its barrier, its start.
    pub case: Case,
    /// Duration and accuracy.
    pub settings: Settings,
    /// Whether the file gives the duration.
    pub duration_given: bool,
    /// The source of gamma.
    pub gamma_source: &'static str,
    /// The source of mu.
    pub mu_source: &'static str,
    /// The pendulum in SI units; `None` if they are not known.
    pub units: Option<Units>,
}

/// The largest step limit of a run: some gigabytes of power series.
const MOST_STEPS: u32 = 10_000_000;

impl TryFrom<&Problem> for Simulate {
    type Error = ProblemError;

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
    fn try_from(problem: &Problem) -> Result<Self, ProblemError> {
        let asked = problem.simulate(&[])?;
        // Without swept parameters the case must be admissible as it is.
        asked.case.motion()?;
        Ok(asked)
    }
}

impl Problem {
    /// Reads the motion of this file, in which the `swept` parameters get other values later; they
    /// count as given.
    ///
    /// # Errors
    /// [`ProblemError`] names the section and the key. The numbers are checked by [`Case::motion`].
    ///
    /// ```
    /// use lindstedt::{impact::Parameter, problem::Problem};
    ///
    /// let file: Problem = "[run]\nduration = 10".parse()?;
    /// let asked = file.simulate(&[Parameter::Barrier])?;
    /// assert_eq!(asked.settings.duration, 10.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn simulate(&self, swept: &[Parameter]) -> Result<Simulate, ProblemError> {
        let gives =
            |parameter: Parameter| swept.contains(&parameter) || self.gives_parameter(parameter);
        self.check_swept(swept, gives)?;
        if self.equation.is_some() {
            return refused(
                "simulate follows the paper's equation (7): leave out `equation`, or use `lindstedt derive`",
            );
        }
        self.check_keys(ReadingCommand::Simulate)?;
        refuse_two_forms(gives)?;
        let mut case = self.case()?;
        case.speed_unit = self.speed_unit(swept);
        let settings = self.settings()?;
        self.check_side(swept)?;
        self.check_pairs(gives)?;
        Ok(Simulate {
            settings,
            duration_given: self.has_key("[run] duration"),
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

    /// Whether this problem, from a file or built in code, gives a parameter.
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
            _ => self.has_key(&parameter.to_string()),
        }
    }

    /// The numbers of the pendulum and its barrier, as they are given.
    pub(super) fn case(&self) -> Result<Case, ProblemError> {
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
            Some(other) => {
                return refused(format!(
                    "[damping] friction `{other}` is neither \"exact\" nor \"arctangent\""
                ));
            }
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
            design: self.design()?,
        })
    }

    /// `[run]`
    pub(super) fn settings(&self) -> Result<Settings, ProblemError> {
        let tolerance = self.run.integrator_tolerance;
        if !(1e-15..=0.01).contains(&tolerance) {
            return refused(format!(
                "[run] integrator_tolerance must lie between 1e-15 and 0.01, not {tolerance:e}: 1e-10 is a good choice"
            ));
        }
        let maximum_steps = self.run.step_limit()?;
        let duration = self.run.duration()?;
        Ok(Settings {
            duration,
            // The errors of some hundred steps add up, and impacts multiply them.
            relative_tolerance: (1e-2 * tolerance).max(1e-15),
            absolute_tolerance: 1e-4 * tolerance,
            maximum_steps,
            ..Settings::default()
        })
    }

    /// Refuses to sweep a parameter without effect: because there is no barrier, because gamma is
    /// given or swept as well, or because a factor of it is zero.
    fn check_swept(
        &self,
        swept: &[Parameter],
        gives: impl Fn(Parameter) -> bool,
    ) -> Result<(), ProblemError> {
        use Parameter::{
            AtSpeed, Barrier as Place, Beta, ContactDamping as Coefficient, FrequencyRatio, Gamma,
            Gravity, Lambda, Length, Mass, Modulus, Mu, MuOverGamma, Radius, Restitution, Torque,
            Viscous,
        };
        let zero = |key: Parameter, given: Option<f64>| {
            !swept.contains(&key) && given.unwrap_or(0.0) == 0.0
        };
        // c = 2*zeta*m*omega, torque = alpha*m*g*L; a main mass is measured in units of the
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
            if let Some(key) = first {
                return refused(format!(
                    "`{key}` changes nothing where `[pendulum] barrier = false`: leave one of them out"
                ));
            }
        }
        if self.contact.gamma == Some(0.0) && !swept.contains(&Gamma) {
            let first = swept.iter().copied().find(|key| *key == Place || of_contact(key));
            first.map_or(Ok(()), |key| beside_zero(key, Gamma))?;
        }
        if swept.contains(&FrequencyRatio) && gives(Beta) && zero(Beta, Some(self.excitation.beta))
        {
            return beside_zero(FrequencyRatio, Beta);
        }
        let of_two = [
            ("[sphere] modulus", self.sphere.modulus.is_some()),
            ("[barrier] poisson", self.barrier.poisson.is_some()),
        ];
        if let (true, Some((key, _))) =
            (swept.contains(&Modulus), of_two.into_iter().find(|(_, given)| *given))
        {
            return refused(format!(
                "`modulus` is that of the barrier alone, and `{key}` makes it that of two bodies: leave out one of them"
            ));
        }
        let without_loss = self.contact.restitution == Some(1.0) && !swept.contains(&Restitution);
        if swept.contains(&AtSpeed) && without_loss {
            return no_effect(AtSpeed, Restitution);
        }
        let without_say = |parameter: &Parameter| match parameter {
            Radius | Modulus => true,
            Mass => !in_si,
            // mu = gamma*lambda*sqrt(g*L), and v/sqrt(g*L) for a speed in m/s
            Length | Gravity => !in_si && !at_speed_in_si && zero(Lambda, self.contact.lambda),
            _ => false,
        };
        match swept.iter().copied().find(without_say).filter(|_| gives(Gamma)) {
            Some(key) => no_effect(key, Gamma),
            None => Ok(()),
        }
    }

    /// Refuses a side without effect: one that refers neither to a single barrier, given or swept,
    /// nor to the release.
    fn check_side(&self, swept: &[Parameter]) -> Result<(), ProblemError> {
        let starts = self.pendulum.start.is_some() || swept.contains(&Parameter::Start);
        if self.pendulum.side.is_none() || !starts || swept.contains(&Parameter::Barrier) {
            return Ok(());
        }
        let barriers = match self.pendulum.barrier {
            Barrier::Absent(_) => "no barrier",
            Barrier::Both(_) => "two barriers",
            Barrier::One(_) => return Ok(()),
        };
        refused(format!(
            "`[pendulum] side` changes nothing beside {barriers} and a start: leave it out"
        ))
    }

    /// Refuses a key that has no effect together with another one, or without another one.
    pub(super) fn check_pairs(
        &self,
        gives: impl Fn(Parameter) -> bool,
    ) -> Result<(), ProblemError> {
        use Parameter::{
            Alpha, Amplitude, AtSpeed, Beta, FrequencyRatio, Restitution, Start, Torque,
        };
        if gives(Amplitude) && gives(Start) {
            return no_effect(Amplitude, Start);
        }
        let friction = "[damping] friction";
        let has_friction = gives(Alpha) || gives(Torque);
        let pairs = [
            (FrequencyRatio.to_string(), gives(FrequencyRatio), Beta, gives(Beta)),
            (AtSpeed.to_string(), gives(AtSpeed), Restitution, gives(Restitution)),
            (friction.to_owned(), self.has_key(friction), Alpha, has_friction),
        ];
        match pairs.into_iter().find(|(_, given, _, other_given)| *given && !other_given) {
            Some((key, _, other, _)) => refused(message_of_missing_key(&key, &other)),
            None => Ok(()),
        }
    }
}

impl Run {
    /// The duration of a motion.
    ///
    /// # Errors
    /// A duration that is not a positive number.
    pub(super) fn duration(&self) -> Result<f64, ProblemError> {
        match self.duration > 0.0 && self.duration.is_finite() {
            true => Ok(self.duration),
            false => {
                refused(format!("[run] duration must be a positive number, not {}", self.duration))
            }
        }
    }

    /// The largest number of steps of an integration.
    ///
    /// # Errors
    /// A limit that is zero or too large, because every step of a motion is stored.
    pub(super) fn step_limit(&self) -> Result<usize, ProblemError> {
        match (1..=MOST_STEPS).contains(&self.step_limit) {
            true => Ok(self.step_limit as usize),
            false => refused(format!(
                "[run] step_limit must be a whole number from 1 to {MOST_STEPS}, not {}",
                self.step_limit
            )),
        }
    }
}

/// The message for a key that has an effect only together with another one.
pub(super) fn message_of_missing_key(key: &str, other: &impl std::fmt::Display) -> String {
    format!("`{key}` changes nothing without `{other}`: give that too, or leave it out")
}

/// The error of a key that has no effect because of another one.
fn no_effect(key: Parameter, other: Parameter) -> Result<(), ProblemError> {
    refused(format!("`{key}` changes nothing where `{other}` is given: leave one of them out"))
}

/// The error of a key that has no effect because another one is zero.
fn beside_zero(key: Parameter, other: Parameter) -> Result<(), ProblemError> {
    refused(format!(
        "`{key}` changes nothing where `{other}` is 0: give it another value, or leave `{key}` out"
    ))
}

/// Refuses a damping that is given in two forms.
pub(super) fn refuse_two_forms(gives: impl Fn(Parameter) -> bool) -> Result<(), ProblemError> {
    let forms: [&[Parameter]; 3] = [
        &ContactDamping::FORMS,
        &[Parameter::Zeta, Parameter::Viscous],
        &[Parameter::Alpha, Parameter::Torque],
    ];
    for forms in forms {
        let mut given = forms.iter().copied().filter(|form| gives(*form));
        if let (Some(key), Some(other)) = (given.next(), given.next()) {
            return refused(format!(
                "`{key}` and `{other}` say the same: give one of them, which is then held fixed"
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::Start;

    fn asked(text: &str) -> Result<Simulate, ProblemError> {
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

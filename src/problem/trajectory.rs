//! What `simulate` reads of a file with an equation or a mechanism of its own.

use thiserror::Error;

use super::simulate::{MOST_STEPS, SimulateError};
use super::{MechanismFileError, Problem, ProblemError, Reader, UnreadKey};
use crate::mechanics::MechanicsError;
use crate::oscillator::{Oscillator, OscillatorError};
use crate::trajectory::{Course, TrajectoryError};

/// Why a file gives no course.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TrajectoryFileError {
    /// A key that belongs to another command.
    #[error(transparent)]
    Unread(#[from] UnreadKey),
    /// The file itself.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// No equation of motion.
    #[error(transparent)]
    Oscillator(#[from] OscillatorError),
    /// No mechanism.
    #[error(transparent)]
    Mechanism(#[from] MechanismFileError),
    /// A limit or a tolerance that cannot be kept.
    #[error(transparent)]
    Run(#[from] SimulateError),
    /// No course.
    #[error(transparent)]
    Trajectory(#[from] TrajectoryError),
}

impl From<MechanicsError> for TrajectoryFileError {
    fn from(error: MechanicsError) -> Self {
        Self::Mechanism(error.into())
    }
}

impl TrajectoryFileError {
    /// What to write instead, where it is known.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Problem(error) => error.help(),
            Self::Mechanism(error) => error.help(),
            Self::Run(error) => error.help(),
            _ => None,
        }
    }
}

impl Problem {
    /// The motion of the equation or the mechanism of the file, from rest at zero: its start and
    /// its values are still to be given.
    ///
    /// # Errors
    /// [`TrajectoryFileError`].
    ///
    /// ```
    /// use lindstedt::problem::Problem;
    ///
    /// let file: Problem = "equation = \"x'' + k*x = 0\"\n[run]\nduration = 10".parse()?;
    /// let course = file.course()?;
    /// assert_eq!((course.duration, course.parameters()), (10.0, vec!["k".into()]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn course(&self) -> Result<Course, TrajectoryFileError> {
        self.check_keys(Reader::Trajectory)?;
        let mut course = match (&self.lagrangian, &self.equation) {
            (Some(_), _) => {
                let mechanism = self.mechanism()?.mechanism;
                Course::of_mechanism(&mechanism, &mechanism.equations()?)?
            }
            (None, Some(equation)) => Course::of_equation(&Oscillator::parse(equation)?),
            (None, None) => return Err(MechanismFileError::NoMechanism.into()),
        };
        let run = self.run;
        if !(run.duration > 0.0 && run.duration.is_finite()) {
            return Err(SimulateError::Duration(run.duration).into());
        }
        if run.step_limit == 0 || run.step_limit > MOST_STEPS {
            return Err(SimulateError::StepLimit(run.step_limit).into());
        }
        course.duration = run.duration;
        course.step_limit = usize::try_from(run.step_limit).unwrap_or(usize::MAX);
        Ok(course)
    }
}

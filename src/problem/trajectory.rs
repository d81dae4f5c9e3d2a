//! The input of `simulate` from a file with an equation or a mechanism of its own.

use super::formula::number_or_text;
use super::mechanism::no_mechanism;
use super::{Problem, ProblemError, ReadingCommand};
use crate::coupled::CoupledEquations;
use crate::expr::parse_expression;
use crate::oscillator::Oscillator;
use crate::trajectory::TrajectoryRequest;

impl Problem {
    /// The motion of the equation or the mechanism of the file, from rest at zero: its initial
    /// state and its values are to be set by the caller.
    ///
    /// # Errors
    /// [`ProblemError`] names the key.
    ///
    /// ```
    /// use lindstedt::problem::Problem;
    ///
    /// let file: Problem = "equation = \"x'' + k*x = 0\"\n[run]\nduration = 10".parse()?;
    /// let course = file.course()?;
    /// assert_eq!((course.duration, course.parameters()), (10.0, vec!["k".into()]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn course(&self) -> Result<TrajectoryRequest, ProblemError> {
        self.check_keys(ReadingCommand::Trajectory)?;
        let mut course = match (&self.lagrangian, &self.equation) {
            (Some(_), _) => {
                let mechanism = self.mechanism()?.mechanism;
                TrajectoryRequest::of_mechanism(&mechanism, &mechanism.equations()?)?
            }
            (None, Some(equations)) if equations.contains(';') => {
                let coupled = CoupledEquations::parse(equations).map_err(|error| {
                    ProblemError::new(error.to_string()).with_help(error.help())
                })?;
                TrajectoryRequest::of_coupled(&coupled)
            }
            (None, Some(equation)) => match Oscillator::parse(equation) {
                Ok(oscillator) => TrajectoryRequest::of_equation(&oscillator),
                // An equation of first order is one of coupled equations.
                Err(error) => match CoupledEquations::parse(equation) {
                    Ok(first_order) => TrajectoryRequest::of_coupled(&first_order),
                    Err(_) => return Err(error.into()),
                },
            },
            (None, None) => return Err(no_mechanism()),
        };
        if let Some(value) = &self.static_friction {
            let text = number_or_text(value, "`static_friction`")?;
            let ratio = parse_expression(&text)
                .map_err(|error| ProblemError::new(format!("`static_friction`: {error}")))?;
            course.static_friction = Some(ratio);
        }
        course.duration = self.run.duration()?;
        course.step_limit = self.run.step_limit()?;
        Ok(course)
    }
}

//! The rigid walls and the events of a problem file.

use super::formula::number_or_text;
use super::{Problem, ProblemError};
use crate::expr::{Expr, parse_expression};

impl Problem {
    /// The walls of the file: the side on which motions are allowed, as text, and the coefficient of
    /// restitution, if it is given.
    ///
    /// # Errors
    /// [`ProblemError`] names the key.
    ///
    /// ```
    /// use lindstedt::problem::Problem;
    ///
    /// let text = "equation = \"x'' + x = 0\"\n[[wall]]\nbound = \"x < d\"\nrestitution = 0.8";
    /// let walls = text.parse::<Problem>()?.walls()?;
    /// assert_eq!((walls[0].0.as_str(), walls[0].1.as_ref().map(ToString::to_string)), ("x < d", Some("4/5".to_owned())));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn walls(&self) -> Result<Vec<(String, Option<Expr>)>, ProblemError> {
        let wall = |(bound, restitution): (&String, Option<&toml::Value>)| {
            let restitution = restitution.map(|value| {
                let key = format!("`restitution` of the wall `{bound}`");
                let text = number_or_text(value, &key)?;
                parse_expression(&text)
                    .map_err(|error| ProblemError::new(format!("{key}: {error}")))
            });
            Ok((bound.clone(), restitution.transpose()?))
        };
        self.wall.iter().map(|own| (&own.bound, own.restitution.as_ref())).map(wall).collect()
    }

    /// The events of the file, in the grammar of [`parse_event`](crate::expr::parse_event).
    ///
    /// ```
    /// use lindstedt::problem::Problem;
    ///
    /// let text = "equation = \"x'' + x = 0\"\n[[event]]\nwhen = \"x < 0\"\nset = [\"x = 0\", \"x' = -x'\"]";
    /// assert_eq!(text.parse::<Problem>()?.events(), ["x < 0: x = 0; x' = -x'"]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn events(&self) -> Vec<String> {
        self.event.iter().map(|event| format!("{}: {}", event.when, event.set)).collect()
    }
}

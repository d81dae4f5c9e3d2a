//! The rigid walls of a problem file.

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
}

//! The input of `derive`, `compare` and `response` from a problem file: an equation, its method and
//! its values.

use super::{Order, Problem, ProblemError, ReadingCommand, refused};
use crate::expr::parse_expression;
use crate::symbol::Symbol;
use crate::values::Values;

/// An equation of motion and the choices that a file makes for it, as text; choices that it leaves
/// out are `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FormulaProblem<'a> {
    /// The equation.
    pub equation: &'a str,
    /// The equilibrium to swing about, `x = 1`.
    pub about: Option<&'a str>,
    /// The small parameter.
    pub small: Option<&'a str>,
    /// The resonance, Omega to omega0.
    pub resonance: Option<&'a str>,
    /// The name of the method.
    pub method: Option<&'a str>,
    /// The order, or the degrees of an approximant.
    pub order: Option<Order>,
    /// The name of the amplitude convention.
    pub amplitude: Option<&'a str>,
}

impl Problem {
    /// The equation of the file and its choices, for one of the commands that derive formulas.
    ///
    /// # Errors
    /// A key that this command would ignore; no equation.
    ///
    /// ```
    /// use lindstedt::problem::{Problem, ReadingCommand};
    ///
    /// let file: Problem = "equation = \"x'' + x + eps*x^3 = 0\"\nsmall = \"eps\"".parse()?;
    /// assert_eq!(file.formula(ReadingCommand::Derive)?.small, Some("eps"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn formula(&self, reader: ReadingCommand) -> Result<FormulaProblem<'_>, ProblemError> {
        self.check_keys(reader)?;
        self.check_derived_equation()?;
        let Some(equation) = self.equation.as_deref() else {
            let help = "equation = \"x'' + sin(x) = 0\"".to_owned();
            return Err(ProblemError::new("the file has no `equation`").with_help(help));
        };
        Ok(FormulaProblem {
            equation,
            about: self.about.as_deref(),
            small: self.small.as_deref(),
            resonance: self.resonance.as_deref(),
            method: self.method.as_deref(),
            order: self.order,
            amplitude: self.amplitude.as_deref(),
        })
    }

    /// `[values]` as exact numbers: `1.5` is 3/2.
    ///
    /// # Errors
    /// A value that is neither a number nor an expression without symbols.
    ///
    /// ```
    /// use lindstedt::problem::Problem;
    ///
    /// let file: Problem = "equation = \"x'' + x + eps*x^3 = 0\"\n[values]\neps = 0.1".parse()?;
    /// let (name, value) = file.exact_values()?.iter().map(|(name, value)| (name, value.to_string())).next().ok_or("none")?;
    /// assert_eq!((name.name(), value.as_str()), ("eps", "1/10"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn exact_values(&self) -> Result<Values, ProblemError> {
        let mut values = Values::default();
        for (name, value) in &self.values {
            let text = number_or_text(value, &format!("the value of `{name}` in [values]"))?;
            let value = parse_expression(&text).map_err(|error| {
                ProblemError::new(format!("the value of `{name}` in [values]: {error}"))
            })?;
            values.insert(Symbol::new(name), value)?;
        }
        Ok(values)
    }

    /// The values of [`Problem::exact_values`] that occur in the equation of motion: that of a
    /// symbol that cancels from the energies, as a mass does, is left out.
    ///
    /// # Errors
    /// As there.
    ///
    /// ```
    /// use lindstedt::problem::Problem;
    ///
    /// let file: Problem = "[lagrangian]\ncoordinates = [\"x\"]\nkinetic = \"m*x'^2/2\"\npotential = \"m*g*x^2/2\"\n[values]\nm = 2\ng = 3".parse()?;
    /// assert_eq!(file.values_of_motion()?.iter().count(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn values_of_motion(&self) -> Result<Values, ProblemError> {
        self.values_with(&[])
    }

    /// The values of [`Problem::values_of_motion`] and those of `needed`, such as a mass without
    /// which the energy has no number.
    ///
    /// # Errors
    /// As there.
    pub fn values_with(&self, needed: &[Symbol]) -> Result<Values, ProblemError> {
        let idle = self.cancelled.iter().filter(|name| !needed.contains(name));
        let idle: Vec<Symbol> = idle.copied().collect();
        let (_, others) = self.exact_values()?.split(&idle);
        Ok(others)
    }
}

/// The text of a value that is a number or an expression.
///
/// # Errors
/// [`ProblemError`] names the key.
pub(super) fn number_or_text(value: &toml::Value, key: &str) -> Result<String, ProblemError> {
    match value {
        toml::Value::String(text) => Ok(text.clone()),
        toml::Value::Integer(number) => Ok(number.to_string()),
        // The shortest decimal that reads back to the same float is what was typed.
        toml::Value::Float(number) if number.is_finite() => Ok(number.to_string()),
        _ => refused(format!("{key} should be a number, or text such as \"pi/3\"")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_exact() {
        let problem: Problem = "[values]\nA = 0.323\nB = \"pi/3\"\nC = 2".parse().unwrap();
        let values = problem.exact_values().unwrap();
        let texts: Vec<String> =
            values.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        assert_eq!(texts, ["A = 323/1000", "B = pi/3", "C = 2"]);
        assert!("[values]\nA = \"k\"".parse::<Problem>().unwrap().exact_values().is_err());
    }
}

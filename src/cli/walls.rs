//! `--wall` and `--restitution`: rigid walls of the command line or of a file; `--contact`: walls that
//! give way.

use clap::Args;

use crate::expr::{Expr, expression_in_grammar};
use crate::problem::{Problem, WallSection};
use crate::wall::Wall;

use super::Failure;
use super::problem::expression;

/// The options of a command that takes rigid walls.
#[derive(Args, Clone, Default)]
pub(super) struct WallArguments {
    /// A rigid wall, by the side on which motions are allowed ("x < 1", "x - y > -d",
    /// "-1 < x < 1"); repeatable
    #[arg(long, value_name = "x < d", allow_hyphen_values = true)]
    pub(super) wall: Vec<String>,
    /// The speed after an impact over that before, between 0 and 1: one for all walls, or one for
    /// each
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    pub(super) restitution: Vec<String>,
}

impl WallArguments {
    /// The walls: those of the command line, or else of the file; `--restitution` wins over the file.
    ///
    /// # Errors
    /// A text that is no wall; a wall without a coefficient of restitution.
    pub(super) fn walls(&self, problem: &Problem) -> Result<Vec<Wall>, Failure> {
        let own: Vec<Expr> = self
            .restitution
            .iter()
            .flat_map(|text| match text.contains('(') {
                true => vec![text.as_str()],
                false => text.split(',').collect(),
            })
            .map(|text| {
                expression(text)
                    .map_err(|error| Failure::Usage(format!("--restitution {text}: {error}")))
            })
            .collect::<Result<_, _>>()?;
        let bounds: Vec<(String, Option<Expr>)> = match self.wall.is_empty() {
            true => problem.walls().map_err(|error| Failure::refused(&error, error.help()))?,
            false => self.wall.iter().map(|bound| (bound.clone(), None)).collect(),
        };
        if bounds.is_empty() && !own.is_empty() {
            return Err(Failure::Usage(
                "--restitution belongs to a wall: give --wall \"x < 1\", or [[wall]] in the file"
                    .to_owned(),
            ));
        }
        let mut walls: Vec<Wall> = Vec::new();
        for (bound, of_file) in bounds {
            let Some(restitution) = own.first().cloned().or(of_file) else {
                return Err(Failure::Usage(format!(
                    "the wall `{bound}` needs its coefficient of restitution: --restitution 0.8, say, or 1 for an impact without loss"
                )));
            };
            let bound = expression_in_grammar(&bound);
            let read = Wall::parse(&bound, &restitution);
            walls.extend(
                read.map_err(|error| Failure::because(format!("wall `{bound}`: {error}")))?,
            );
        }
        if own.len() > 1 && own.len() != walls.len() {
            return Err(Failure::Usage(format!(
                "{} values of --restitution for {} walls: give one for all, or one for each",
                own.len(),
                walls.len()
            )));
        }
        if own.len() > 1 {
            for (wall, restitution) in walls.iter_mut().zip(own) {
                wall.restitution = restitution;
            }
        }
        Ok(walls)
    }
}

/// The option of a command that takes walls that give way.
#[derive(Args, Clone, Default)]
pub(super) struct ContactArguments {
    /// A wall that gives way, and its law: hertz, hunt-crossley, kelvin-voigt, kelvin-voigt-no-pull or
    /// step ("x < 1: hunt-crossley K=1e5 restitution=0.8 speed=2"); repeatable
    #[arg(long, value_name = "x < d: LAW K=...", allow_hyphen_values = true)]
    pub(super) contact: Vec<String>,
}

impl ContactArguments {
    /// The problem with the forces of these contacts in its equations.
    ///
    /// # Errors
    /// A text that is no contact, or a problem without equations.
    pub(super) fn on(&self, problem: Problem) -> Result<Problem, Failure> {
        if self.contact.is_empty() {
            return Ok(problem);
        }
        let wall = |text: &String| {
            let parts = text.split_once(':').map(|(bound, law)| (bound.trim(), law.trim()));
            let (bound, law) = parts.ok_or_else(|| {
                Failure::Usage(format!(
                    "--contact \"{text}\": a bound, a colon and a law are expected, such as \"x < 1: hertz K=1e5\""
                ))
            })?;
            Ok(WallSection {
                bound: bound.to_owned(),
                restitution: None,
                contact: Some(law.to_owned()),
            })
        };
        let walls = self.contact.iter().map(wall).collect::<Result<_, Failure>>()?;
        problem.with_walls(walls).map_err(|error| Failure::refused(&error, error.help()))
    }
}

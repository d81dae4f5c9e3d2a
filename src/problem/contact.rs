//! Compliant contacts of a problem: their laws in words, the damping of a wanted restitution, and
//! their forces in the equations.
//!
//! ```text
//! hertz K=1e5                                             K p^n, n = 3/2
//! hunt-crossley K=1e5 restitution=0.8 speed=1             lambda = s/v, G(s) = G(-e s), G(z) = z - ln(1 + z)
//! kelvin-voigt K=1e3 restitution=0.8                      c = 2 zeta sqrt(K m), zeta by e
//! kelvin-voigt-no-pull K=1e3 restitution=0.8
//! step K=1e5 d=1e-3 restitution=0.8 speed=1               c by Runge-Kutta and a root
//! ```

use std::collections::BTreeMap;
use std::ops::Range;

use num_traits::{Signed, Zero};

use super::{Problem, ProblemError, WallSection, refused};
use crate::contact::{CompliantContact, ContactLoss, Masses};
use crate::coupled::CoupledEquations;
use crate::expr::{
    Expr, ExprError, equation_in_grammar, excerpt, expression_in_grammar, parse_equation,
    parse_equations, parse_expression, parse_inequality,
};
use crate::impact::contact::hunt_crossley::damping_for;
use crate::impact::contact::{ContactError, Dashpot, StepContact};
use crate::spelling::nearest;
use crate::wall::WallError;

/// The laws and the names of their quantities.
const LAWS: [(&str, &[&str]); 5] = [
    ("hertz", &["K", "n"]),
    ("hunt-crossley", &["K", "n", "lambda", "restitution", "speed"]),
    ("kelvin-voigt", &["K", "c", "restitution"]),
    ("kelvin-voigt-no-pull", &["K", "c", "restitution"]),
    ("step", &["K", "n", "d", "c", "restitution", "speed"]),
];

/// A contact in words: a law and its quantities.
struct ContactText<'a> {
    text: &'a str,
    law: &'static str,
    quantities: BTreeMap<&'static str, Expr>,
}

/// The words of a text and their places.
fn words(text: &str) -> impl Iterator<Item = (Range<usize>, &str)> {
    let start = |word: &str| word.as_ptr() as usize - text.as_ptr() as usize;
    text.split_whitespace().map(move |word| (start(word)..start(word) + word.len(), word))
}

impl<'a> ContactText<'a> {
    /// Reads a law and its quantities.
    ///
    /// # Errors
    /// An unknown law or quantity, one that is given twice, a value with an error of syntax.
    fn parse(text: &'a str) -> Result<Self, ProblemError> {
        let names = LAWS.map(|(name, _)| name);
        let mut words = words(text);
        let Some((place, first)) = words.next() else {
            let help = format!("a contact begins with its law: {}", names.join(", "));
            return Err(ProblemError::new("the contact is empty").with_help(help));
        };
        let Some((law, keys)) = LAWS.into_iter().find(|(name, _)| *name == first) else {
            let help = match nearest(first, names) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the laws are {}", names.join(", ")),
            };
            return Err(
                at(text, &place, &format!("`{first}` is no law of contact")).with_help(help)
            );
        };
        let mut quantities = BTreeMap::new();
        for (place, word) in words {
            let Some((name, value)) = word.split_once('=') else {
                let help =
                    "such as K=1e5, without spaces around `=` or within the value".to_owned();
                return Err(
                    at(text, &place, "a quantity and its value are expected").with_help(help)
                );
            };
            let Some(key) = keys.iter().find(|key| **key == name) else {
                let what = format!("the law `{law}` has no quantity `{name}`");
                let help = match (name, law) {
                    ("restitution", "hertz") => {
                        "`hertz` loses nothing; with a restitution take hunt-crossley".to_owned()
                    }
                    ("speed", law) if law.starts_with("kelvin") => {
                        "its restitution is the same at any speed: leave it out".to_owned()
                    }
                    _ => format!("its quantities are {}", keys.join(", ")),
                };
                return Err(at(text, &place, &what).with_help(help));
            };
            let value = parse_expression(&expression_in_grammar(value))
                .map_err(|error| at(text, &place, &error.message))?;
            check_sign(key, &value).map_err(|what| at(text, &place, &what))?;
            if quantities.insert(*key, value).is_some() {
                return Err(at(text, &place, &format!("`{name}` is given twice")));
            }
        }
        let words = Self { text, law, quantities };
        words.check()?;
        Ok(words)
    }

    /// Refuses a law without what it needs, and quantities that exclude each other.
    fn check(&self) -> Result<(), ProblemError> {
        let has = |name: &str| self.quantities.contains_key(name);
        let lack = |what: &str, help: &str| {
            let error = at(self.text, &(0..self.law.len()), what);
            Err(error.with_help(help.to_owned()))
        };
        if !has("K") {
            return lack(
                "the contact has no stiffness",
                "K=1e5, the force at a penetration of one",
            );
        }
        if self.law == "step" && !has("d") {
            return lack("the contact has no depth of full damping", "d=1e-3, say");
        }
        let Some(damping) = self.damping_name() else { return Ok(()) };
        match (has(damping), has("restitution")) {
            (true, true) => lack(
                &format!("`{damping}` and `restitution` are two dampings"),
                "leave one of them out",
            ),
            (false, false) => lack(
                "the contact has no damping",
                &format!("restitution=0.8, or {damping}=0 for none"),
            ),
            (true, false) if has("speed") => {
                lack("`speed` belongs to a restitution", "leave out the speed")
            }
            (false, true) if self.law != "hunt-crossley" && self.law != "step" => Ok(()),
            (false, true) if !has("speed") => lack(
                "the restitution of this law depends on the speed of impact",
                "speed=1, at which the restitution holds",
            ),
            _ => Ok(()),
        }
    }

    /// The name of the coefficient of damping; `None` for a law without one.
    fn damping_name(&self) -> Option<&'static str> {
        match self.law {
            "hertz" => None,
            "hunt-crossley" => Some("lambda"),
            _ => Some("c"),
        }
    }

    /// A quantity; zero where it is not given.
    fn quantity(&self, name: &str) -> Expr {
        self.quantities.get(name).cloned().unwrap_or_else(Expr::zero)
    }

    /// A quantity as a number.
    fn number(&self, name: &str, reason: &str) -> Result<f64, ProblemError> {
        let value = self.quantity(name);
        value.evaluate(&BTreeMap::new()).map_err(|_| {
            let word = words(self.text).find(|(_, word)| word.starts_with(&format!("{name}=")));
            let place = word.map_or(0..self.law.len(), |(place, _)| place);
            let what = format!("`{value}` is no number, but {reason}");
            let coefficient = self.damping_name().unwrap_or("c");
            let help = format!("give a number, or {coefficient} in place of the restitution");
            at(self.text, &place, &what).with_help(help)
        })
    }

    /// The contact of this law at a gap.
    fn contact(&self, gap: Expr, masses: &Masses) -> Result<CompliantContact, ProblemError> {
        let power = || match self.quantities.get("n") {
            Some(exponent) => exponent.clone(),
            None => Expr::number(crate::exact::rational::ratio(3, 2)),
        };
        let exponent = if self.law.starts_with("kelvin") { Expr::one() } else { power() };
        let coefficient = match (self.damping_name(), self.quantities.contains_key("restitution")) {
            (Some(_), true) => self.damping(&gap, masses)?,
            (Some(name), false) => self.quantity(name),
            (None, _) => Expr::zero(),
        };
        let loss = match self.law {
            "hertz" => ContactLoss::None,
            "hunt-crossley" => ContactLoss::Factor(coefficient),
            "step" => ContactLoss::Step { coefficient, depth: self.quantity("d") },
            law => ContactLoss::Dashpot { coefficient, pulls: law == "kelvin-voigt" },
        };
        Ok(CompliantContact { gap, stiffness: self.quantity("K"), exponent, loss })
    }

    /// The coefficient of damping by the wanted restitution.
    fn damping(&self, gap: &Expr, masses: &Masses) -> Result<Expr, ProblemError> {
        let reason = "the damping is computed from the restitution";
        let wanted = self.number("restitution", reason)?;
        let refused =
            |error: ContactError| at(self.text, &(0..self.text.len()), &error.to_string());
        let algebra = |error: ExprError| ProblemError::new(error);
        match self.law {
            "hunt-crossley" => {
                let product = decimal(damping_for(wanted).map_err(refused)?)?;
                Expr::divide(&product, &self.quantity("speed")).map_err(algebra)
            }
            "step" => {
                let reason = "the damping of a step is computed in numbers";
                let contact = StepContact {
                    exponent: match self.quantities.contains_key("n") {
                        true => self.number("n", reason)?,
                        false => 1.5,
                    },
                    stiffness: self.number("K", reason)?,
                    depth: self.number("d", reason)?,
                    speed: self.number("speed", reason)?,
                    mass: self.mass(gap, masses)?.evaluate(&BTreeMap::new()).map_err(|_| {
                        at(
                            self.text,
                            &(0..self.law.len()),
                            &format!("the mass is no number, but {reason}"),
                        )
                        .with_help("write the masses as numbers, or give c".to_owned())
                    })?,
                };
                decimal(contact.damping_for(wanted).map_err(refused)?)
            }
            law => {
                let dashpot = match law {
                    "kelvin-voigt" => Dashpot::Pulls,
                    _ => Dashpot::DoesNotPull,
                };
                let ratio = dashpot.damping_ratio_for(wanted).map_err(refused)?;
                let product = self.quantity("K") * self.mass(gap, masses)?;
                match product.evaluate(&BTreeMap::new()) {
                    Ok(product) => decimal(2.0 * ratio * product.sqrt()),
                    Err(_) => Ok(decimal(2.0 * ratio)? * product.sqrt().map_err(algebra)?),
                }
            }
        }
    }

    /// The mass that the contact sees.
    ///
    /// # Errors
    /// A mass that depends on the place.
    fn mass(&self, gap: &Expr, masses: &Masses) -> Result<Expr, ProblemError> {
        let mass = masses.effective(gap).map_err(of_wall)?;
        match masses.coordinates.iter().find(|name| mass.contains(**name)) {
            None => Ok(mass),
            Some(name) => Err(ProblemError::new(format!(
                "the mass `{mass}` that the wall `{gap} = 0` sees changes with `{name}`, so that no damping has the restitution everywhere"
            ))
            .with_help("give c in place of the restitution".to_owned())),
        }
    }
}

/// Refuses a quantity that is a number of the wrong sign: a contact that pulls, or one that gains energy.
fn check_sign(name: &str, value: &Expr) -> Result<(), String> {
    let Some(number) = value.as_number() else { return Ok(()) };
    let is_damping = name == "c" || name == "lambda";
    match name {
        // Its range has a sentence of its own.
        "restitution" => Ok(()),
        _ if number.is_positive() || is_damping && number.is_zero() => Ok(()),
        _ if is_damping => {
            Err(format!("`{name}` must not be negative: the contact would gain energy"))
        }
        _ => Err(format!("`{name}` must be positive")),
    }
}

/// An error at a place of the text of a contact, shown with a caret.
fn at(text: &str, place: &Range<usize>, what: &str) -> ProblemError {
    let [shown, carets] = excerpt(text, place);
    ProblemError::new(format!("the contact: {what}\n  {shown}\n  {carets}"))
}

/// The decimal number nearest to a float.
fn decimal(value: f64) -> Result<Expr, ProblemError> {
    parse_expression(&value.to_string()).map_err(|_| {
        ProblemError::new(format!("the damping {value:e} of the contact is no number"))
    })
}

fn of_wall(error: WallError) -> ProblemError {
    let help = match error {
        WallError::WithoutMass(_) => Some(
            "write each equation with its mass before the acceleration, m1*x'' + ... = 0"
                .to_owned(),
        ),
        _ => None,
    };
    ProblemError::new(error).with_help(help)
}

/// The contacts of walls in equations of these masses.
fn contacts(walls: &[WallSection], masses: &Masses) -> Result<Vec<CompliantContact>, ProblemError> {
    let mut contacts = Vec::new();
    for WallSection { bound, restitution, contact } in walls {
        let within = |error: ProblemError| {
            let help = error.help();
            ProblemError::new(format!("wall `{bound}`: {error}")).with_help(help)
        };
        let Some(text) = contact else { continue };
        if restitution.is_some() {
            return Err(within(ProblemError::new(
                "`restitution` belongs to a rigid wall, and this one has a contact",
            ))
            .with_help("restitution=0.8 within the contact, or leave one of them out".to_owned()));
        }
        let words = ContactText::parse(text).map_err(within)?;
        let gaps = parse_inequality(&expression_in_grammar(bound))
            .map_err(|error| within(ProblemError::new(error)))?;
        for gap in gaps {
            contacts.push(words.contact(gap, masses).map_err(within)?);
        }
    }
    Ok(contacts)
}

/// A term after others: ` + k*x` or ` - k*x`; nothing for zero.
fn appended(term: &Expr) -> String {
    let text = term.to_string();
    match text.strip_prefix('-') {
        _ if term.is_zero() => String::new(),
        Some(rest) => format!(" - {}", rest.trim_start()),
        None => format!(" + {text}"),
    }
}

impl Problem {
    /// Returns the problem with walls added to those of the file.
    ///
    /// # Errors
    /// As for a file with these walls.
    ///
    /// ```
    /// use lindstedt::problem::{Problem, WallSection};
    ///
    /// let wall = WallSection { bound: "x < d".to_owned(), restitution: None, contact: Some("hertz K=k2".to_owned()) };
    /// let problem = "equation = \"x'' + x = 0\"".parse::<Problem>()?.with_walls(vec![wall])?;
    /// assert_eq!(problem.equation.as_deref(), Some("x'' + x + k2*max(0, x - d)^(3/2) = 0"));
    /// # Ok::<(), lindstedt::problem::ProblemError>(())
    /// ```
    pub fn with_walls(mut self, walls: Vec<WallSection>) -> Result<Self, ProblemError> {
        self.wall.extend(walls);
        if self.lagrangian.is_some() {
            // The equation is derived anew.
            self.equation = None;
        }
        self.with_contact_forces()?.with_derived_equation()
    }

    /// Returns the problem with the forces of its compliant walls in its equations; rigid walls stay
    /// as they are.
    ///
    /// # Errors
    /// A contact that cannot be read; equations without masses; a file without equations.
    pub(super) fn with_contact_forces(mut self) -> Result<Self, ProblemError> {
        let (soft, rigid): (Vec<WallSection>, Vec<WallSection>) =
            std::mem::take(&mut self.wall).into_iter().partition(|wall| wall.contact.is_some());
        self.wall = rigid;
        if soft.is_empty() {
            return Ok(self);
        }
        if self.lagrangian.is_some() {
            return self.with_forces_on_mechanism(&soft);
        }
        let Some(text) = &self.equation else {
            return refused(
                "a contact of [[wall]] acts in an `equation` or a [lagrangian], which the file does not have; the barrier of the pendulum has [contact]",
            );
        };
        let text = expand_notation(text);
        let sides = match text.contains(';') {
            true => parse_equations(&text).map_err(ProblemError::new)?,
            false => {
                let equation = parse_equation(&text).map_err(ProblemError::new)?;
                vec![(equation.left, equation.right)]
            }
        };
        let coupled = CoupledEquations::new(sides)
            .map_err(|error| ProblemError::new(&error).with_help(error.help()))?;
        let masses = Masses::of_equations(&coupled);
        let mut terms = vec![String::new(); coupled.coordinates.len()];
        for contact in contacts(&soft, &masses)? {
            for (own, term) in terms.iter_mut().zip(contact.left_terms(&masses).map_err(of_wall)?) {
                own.push_str(&appended(&term));
            }
        }
        let parts = text.split(';').zip(terms).map(|(part, terms)| match part.split_once('=') {
            Some((left, right)) => format!("{}{terms} ={right}", left.trim_end()),
            None => format!("{}{terms}", part.trim_end()),
        });
        self.equation = Some(parts.collect::<Vec<_>>().join(";"));
        Ok(self)
    }

    /// The forces of contacts as forces of the mechanism.
    fn with_forces_on_mechanism(mut self, soft: &[WallSection]) -> Result<Self, ProblemError> {
        let masses = Masses::of_mechanism(&self.mechanism()?.mechanism.equations()?);
        let contacts = contacts(soft, &masses)?;
        if let Some(section) = &mut self.lagrangian {
            for contact in contacts {
                let forces = contact.generalised_forces(&masses).map_err(of_wall)?;
                for (name, force) in masses.coordinates.iter().zip(forces) {
                    let own = section.forces.entry(name.name().to_owned());
                    own.or_insert_with(|| "0".to_owned()).push_str(&appended(&force));
                }
            }
        }
        Ok(self)
    }
}

/// Equations with the notations of print in the grammar.
fn expand_notation(text: &str) -> String {
    text.split(';').map(equation_in_grammar).collect::<Vec<_>>().join(";")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The equations of a file with this wall.
    fn with_wall(equation: &str, bound: &str, contact: &str) -> Result<String, ProblemError> {
        let file = format!(
            "equation = \"{equation}\"\n[[wall]]\nbound = \"{bound}\"\ncontact = \"{contact}\""
        );
        Ok(file.parse::<Problem>()?.equation.unwrap_or_default())
    }

    #[test]
    fn contacts_are_terms_of_the_equation_as_it_is_written() {
        for (equation, bound, contact, expected) in [
            (
                "m*x'' + 0.5*x = F*cos(w*t)",
                "x < d",
                "hertz K=k2",
                "m*x'' + 0.5*x + k2*max(0, x - d)^(3/2) = F*cos(w*t)",
            ),
            ("x'' = -x", "x > 0", "hertz K=5 n=2", "x'' - 5*max(0, -x)^2 = -x"),
            ("x = -x''", "x < 1", "hertz K=5 n=2", "x + 5*max(0, x - 1)^2 = -x''"),
            ("-x = x''", "x < 1", "hertz K=5 n=2", "-x - 5*max(0, x - 1)^2 = x''"),
            (
                "x'' + x = 0",
                "x > Z*sin(t)",
                "kelvin-voigt K=k c=b",
                "x'' + x - H(-x + Z*sin(t))*(k*(-x + Z*sin(t)) + b*(-x' + Z*cos(t))) = 0",
            ),
        ] {
            let found = with_wall(equation, bound, contact).expect(equation);
            let sides = |text: &str| {
                let equation = parse_equation(text).expect(text);
                (equation.left - equation.right).expand().expect(text)
            };
            assert_eq!(sides(&found), sides(expected), "{found}");
            assert_eq!(found.split('=').nth(1), expected.split('=').nth(1));
        }
    }

    #[test]
    fn bad_contacts_say_why() {
        for (equation, contact, words) in [
            ("x'' + x = 0", "herz K=1", "did you mean `hertz`"),
            ("x'' + x = 0", "hertz", "no stiffness"),
            ("x'' + x = 0", "hertz K", "a quantity and its value"),
            ("x'' + x = 0", "hertz K=1 K=2", "given twice"),
            ("x'' + x = 0", "hertz K=-5", "`K` must be positive"),
            ("x'' + x = 0", "hertz K=0", "`K` must be positive"),
            ("x'' + x = 0", "hunt-crossley K=1 n=-1 lambda=0", "`n` must be positive"),
            ("x'' + x = 0", "hunt-crossley K=1 lambda=-1", "the contact would gain energy"),
            ("x'' + x = 0", "step K=1 d=0 c=1", "`d` must be positive"),
            ("x'' + x = 0", "hertz K=1 restitution=0.5", "take hunt-crossley"),
            ("x'' + x = 0", "hunt-crossley K=1", "no damping"),
            ("x'' + x = 0", "hunt-crossley K=1 restitution=0.5", "speed=1"),
            ("x'' + x = 0", "hunt-crossley K=1 restitution=0.5 lambda=1", "two dampings"),
            ("x'' + x = 0", "hunt-crossley K=1 lambda=1 speed=1", "belongs to a restitution"),
            ("x'' + x = 0", "hunt-crossley K=1 restitution=1.5 speed=1", "above 0"),
            ("x'' + x = 0", "hunt-crossley K=1 restitution=e speed=1", "is no number"),
            ("x'' + x = 0", "kelvin-voigt K=1 restitution=0.5 speed=1", "the same at any speed"),
            ("x'' + x = 0", "step K=1 c=1", "no depth"),
            ("x'' + x = 0", "step K=k d=1 restitution=0.5 speed=1", "in numbers"),
            ("m*x'' + x = 0", "step K=1 d=1 restitution=0.5 speed=1", "the mass is no number"),
            ("(1 + x^2)*x'' + x = 0", "kelvin-voigt K=1 restitution=0.5", "changes with `x`"),
            ("x' + x = 0", "hertz K=1", "first order"),
            ("x'' + y = 0; y'' + 2*x'' = 0", "hertz K=1", "with its mass"),
        ] {
            let error = with_wall(equation, "x < 1", contact).expect_err(contact);
            let text = format!("{error} {}", error.help().unwrap_or_default());
            assert!(text.contains(words), "{contact}: {text}");
        }
    }
}

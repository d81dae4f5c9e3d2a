//! The laws that a record is compared with: `x'' + loss(x') + spring(x) = 0`.
//!
//! ```text
//! spring: w^2 x,  w^2 x + beta x^3,  w^2 x + b x^2,  w^2 sin x,  k x |x|^(n-1)
//! loss:   0,  2 zeta w x',  alpha w^2 sgn x',  q |x'| x',  r x' |x'|^(p-1),  viscous + Coulomb
//! ```
//!
//! With a spring of power n there is no frequency w at small amplitude, so that its losses are `c x'` and
//! `d sgn x'`. An equation of one's own is a law as well: its symbols without a value are the parameters.

use thiserror::Error;

use crate::expr::{Equation, Expr, Function, Node, parse_equation};
use crate::oscillator::{Oscillator, OscillatorError};
use crate::symbol::Symbol;

/// The names of what is fitted to each record beside the parameters: its initial coordinate and velocity, the offset in its middle and the
/// drift of that per unit of time.
pub(crate) const LOCAL_NAMES: [&str; 4] = ["x0", "v0", "offset", "drift"];

/// The restoring force of a law of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Spring {
    /// `w^2 x`
    Linear,
    /// `w^2 x + beta x^3`
    Duffing,
    /// `w^2 x + b x^2`
    Quadratic,
    /// `w^2 sin x`, for angles in radians
    Pendulum,
    /// `k x |x|^(n-1)`
    Power,
}

/// The damping force of a law of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Loss {
    /// No damping.
    None,
    /// A force proportional to the velocity.
    Viscous,
    /// Dry friction, which is independent of the speed.
    Coulomb,
    /// A force proportional to the square of the speed.
    Quadratic,
    /// A force proportional to a power of the speed, whose exponent is unknown.
    Power,
    /// Viscous damping and dry friction together.
    ViscousAndCoulomb,
}

impl Spring {
    /// The springs of the list.
    pub const ALL: [Self; 5] =
        [Self::Linear, Self::Duffing, Self::Quadratic, Self::Pendulum, Self::Power];

    /// The name in answers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear spring",
            Self::Duffing => "Duffing spring",
            Self::Quadratic => "quadratic spring",
            Self::Pendulum => "pendulum",
            Self::Power => "power-law spring",
        }
    }

    /// The number of its parameters, which are the first ones of a law.
    pub(crate) fn count(self) -> usize {
        self.parameters().len()
    }

    fn parameters(self) -> &'static [&'static str] {
        match self {
            Self::Linear | Self::Pendulum => &["w"],
            Self::Duffing => &["w", "beta"],
            Self::Quadratic => &["w", "b"],
            Self::Power => &["k", "n"],
        }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Linear => "w^2*x",
            Self::Duffing => "w^2*x + beta*x^3",
            Self::Quadratic => "w^2*x + b*x^2",
            Self::Pendulum => "w^2*sin(x)",
            Self::Power => "k*x*abs(x)^(n - 1)",
        }
    }
}

impl Loss {
    /// The losses of the list.
    pub const ALL: [Self; 6] = [
        Self::None,
        Self::Viscous,
        Self::Coulomb,
        Self::Quadratic,
        Self::Power,
        Self::ViscousAndCoulomb,
    ];

    /// The name in answers.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "no damping",
            Self::Viscous => "viscous damping",
            Self::Coulomb => "dry friction",
            Self::Quadratic => "quadratic damping",
            Self::Power => "power-law damping",
            Self::ViscousAndCoulomb => "viscous damping and dry friction",
        }
    }

    /// The parameters beside those of a spring; `has_frequency` says whether it has a frequency w.
    fn parameters(self, has_frequency: bool) -> &'static [&'static str] {
        match (self, has_frequency) {
            (Self::None, _) => &[],
            (Self::Viscous, true) => &["zeta"],
            (Self::Viscous, false) => &["c"],
            (Self::Coulomb, true) => &["alpha"],
            (Self::Coulomb, false) => &["d"],
            (Self::Quadratic, _) => &["q"],
            (Self::Power, _) => &["r", "p"],
            (Self::ViscousAndCoulomb, true) => &["zeta", "alpha"],
            (Self::ViscousAndCoulomb, false) => &["c", "d"],
        }
    }

    fn text(self, has_frequency: bool) -> &'static str {
        match (self, has_frequency) {
            (Self::None, _) => "",
            (Self::Viscous, true) => " + 2*zeta*w*x'",
            (Self::Viscous, false) => " + c*x'",
            (Self::Coulomb, true) => " + alpha*w^2*sgn(x')",
            (Self::Coulomb, false) => " + d*sgn(x')",
            (Self::Quadratic, _) => " + q*abs(x')*x'",
            (Self::Power, _) => " + r*x'*abs(x')^(p - 1)",
            (Self::ViscousAndCoulomb, true) => " + 2*zeta*w*x' + alpha*w^2*sgn(x')",
            (Self::ViscousAndCoulomb, false) => " + c*x' + d*sgn(x')",
        }
    }
}

/// An equation of motion with unknown parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// The name in answers.
    pub name: String,
    /// The equation as the program reads it.
    pub equation: String,
    /// The unknown parameters.
    pub parameters: Vec<Symbol>,
    /// Spring and loss of a law of the list; `None` for an equation of one's own.
    pub parts: Option<(Spring, Loss)>,
    /// The coordinate.
    pub(crate) coordinate: Symbol,
    /// The acceleration as a function of coordinate, velocity and time.
    pub(crate) acceleration: Expr,
}

/// The reason why an equation is not a law with unknown parameters.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LawError {
    /// The equation is not an equation of motion of one coordinate.
    #[error(transparent)]
    Equation(#[from] OscillatorError),
    /// Every symbol has a value.
    #[error("`{0}` has no unknown parameter")]
    NoParameter(String),
    /// A parameter has a name of the start or of the offset.
    #[error("`{0}` is a name of the record: x0 and v0 are its start, offset and drift its centre")]
    Taken(String),
    /// A corner other than `abs(x')` and `sgn(x')` makes the force jump, so that the motion has no
    /// derivative by the parameters.
    #[error("`{0}` jumps, so that the motion has no derivative by the parameters")]
    Jump(String),
}

impl LawError {
    /// A way forward.
    pub fn help(&self) -> &'static str {
        match self {
            Self::Equation(_) => "write one equation such as `x'' + c*x' + k*x = 0`",
            Self::NoParameter(_) => "write a letter in place of a number that is to be found",
            Self::Taken(_) => "write another letter",
            Self::Jump(_) => {
                "write dry friction as `sgn(x')`; other jumps can be rounded off, for example by tanh"
            }
        }
    }
}

impl Law {
    /// The law of the list with this spring and this loss.
    ///
    /// # Errors
    /// [`LawError`] if the text of the table cannot be read, which a test excludes.
    pub fn from_parts(spring: Spring, loss: Loss) -> Result<Self, LawError> {
        let has_frequency = spring != Spring::Power;
        let equation = format!("x'' + {}{} = 0", spring.text(), loss.text(has_frequency));
        let names = spring.parameters().iter().chain(loss.parameters(has_frequency));
        let mut law = Self::parse(&equation)?;
        law.parameters = names.map(|name| Symbol::new(name)).collect();
        law.name = format!("{}, {}", spring.name(), loss.name());
        law.parts = Some((spring, loss));
        Ok(law)
    }

    /// The law of an equation such as `x'' + c*x' + k*x + k3*x^3 = 0`, whose parameters are unknown.
    ///
    /// # Errors
    /// [`LawError`].
    ///
    /// ```
    /// use lindstedt_fit::fit::laws::Law;
    ///
    /// let law = Law::parse("m*x'' + c*x' + k*x + 2*x^3 = 0")?;
    /// let names: Vec<String> = law.parameters.iter().map(|name| name.to_string()).collect();
    /// assert_eq!(names, ["c", "k", "m"]);
    /// # Ok::<(), lindstedt_fit::fit::laws::LawError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, LawError> {
        let equation = parse_equation(text).map_err(OscillatorError::from)?;
        Self::from_equation(&equation, text)
    }

    fn from_equation(equation: &Equation, text: &str) -> Result<Self, LawError> {
        let oscillator = Oscillator::from_equation(equation)?;
        if oscillator.parameters.is_empty() {
            return Err(LawError::NoParameter(text.to_owned()));
        }
        let is_taken = |name: &&Symbol| LOCAL_NAMES.contains(&name.name());
        if let Some(name) = oscillator.parameters.iter().find(is_taken) {
            return Err(LawError::Taken(name.to_string()));
        }
        Ok(Self {
            name: text.to_owned(),
            equation: text.to_owned(),
            parameters: oscillator.parameters.clone(),
            parts: None,
            coordinate: oscillator.coordinate,
            acceleration: -&oscillator.force,
        })
    }

    /// The index of a parameter.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|own| own.name() == name)
    }

    /// Whether the equation contains the time.
    pub fn is_driven(&self) -> bool {
        self.acceleration.contains(Symbol::new("t"))
    }

    /// The parameter that multiplies the time in every sine and cosine of it, `Omega` of
    /// `cos(Omega*t)`; `None` where there is no such parameter, or several.
    pub fn drive_frequency(&self) -> Option<Symbol> {
        let time = Symbol::new("t");
        let angle = |node: &Expr| match node.node() {
            Node::Function(Function::Sin | Function::Cos, own) if own[0].contains(time) => {
                Some(own[0].clone())
            }
            _ => None,
        };
        let rate = |angle: Expr| angle.differentiate(time).ok()?.as_symbol();
        let mut rates = self.acceleration.unique_nodes().filter_map(angle).map(rate);
        let first = rates.next()??;
        let is_only = rates.all(|own| own == Some(first));
        (is_only && self.parameters.contains(&first)).then_some(first)
    }

    /// All laws of the list: every spring with every loss. The pendulum is among them for angles alone.
    pub fn list(is_angle: bool) -> Vec<Self> {
        let springs =
            Spring::ALL.into_iter().filter(|spring| is_angle || *spring != Spring::Pendulum);
        springs
            .flat_map(|spring| Loss::ALL.map(|loss| (spring, loss)))
            .filter_map(|(spring, loss)| Self::from_parts(spring, loss).ok())
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_law_of_the_list_is_read_with_its_parameters() {
        let laws = Law::list(true);
        assert_eq!(laws.len(), Spring::ALL.len() * Loss::ALL.len());
        for law in laws {
            let mut read = Law::parse(&law.equation).unwrap().parameters;
            let mut own = law.parameters.clone();
            read.sort();
            own.sort();
            assert_eq!(read, own, "{}", law.name);
        }
    }
}

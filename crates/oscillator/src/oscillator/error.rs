//! Errors of an equation that is not an oscillator, with advice.

use std::fmt;

use crate::expr::{Expr, ExprError, ParseError, Quotation};
use crate::series::taylor::TaylorError;
use crate::solution::note::Position;
use crate::solution::{Advice, AmplitudeConvention, Method, Setting};
use crate::symbol::Symbol;

/// The reason why an equation is not an oscillator, or not one that can be expanded.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OscillatorError {
    /// The text is not an equation.
    #[error(transparent)]
    Parse(Box<ParseError>),
    /// A step of algebra failed.
    #[error("{0}")]
    Expression(#[from] ExprError),
    /// There is no second derivative.
    #[error("the equation has no `{0}''`: an oscillator needs an acceleration")]
    NoAcceleration(Symbol),
    /// The second derivative does not enter linearly.
    #[error(
        "the acceleration enters as `{0}`, which is not linear in it: solve the equation for x'' first"
    )]
    NonlinearAcceleration(String),
    /// The coefficient of the acceleration vanishes at the equilibrium.
    #[error(
        "the coefficient `{0}` of the acceleration vanishes at rest, so the equation does not determine the motion there"
    )]
    VanishingMass(String),
    /// There is a force at rest, and nowhere near a stable equilibrium.
    #[error("the force at rest is `{0}`, not zero, and no stable equilibrium was found")]
    NoEquilibrium(String),
    /// The force is infinite at zero and attracts so strongly that no motion passes.
    #[error(
        "the force `{force}` pulls towards {coordinate} = 0 {}",
        if *uneven {
            "as 1/x does, and is followed through such a place only where it is odd, which it is not"
        } else {
            "and grows there faster than 1/x: a motion falls in with ever more energy, and nothing says how it would come out"
        }
    )]
    FallsIn {
        /// The force.
        force: String,
        /// The coordinate.
        coordinate: Symbol,
        /// Whether it grows as `1/x` and has an even part; otherwise it grows faster.
        uneven: bool,
    },
    /// There is a force at rest, and stable equilibria only where no motion from rest leads.
    #[error(
        "the force at rest is `{force}`, not zero, and no stable equilibrium was found before the force has a pole or ends; beyond there {} {stable}",
        if stable.positions.len() == 1 { "is one at" } else { "are some at" }
    )]
    BeyondPole {
        /// The force at rest.
        force: String,
        /// The coordinate.
        coordinate: Symbol,
        /// The stable equilibria beyond.
        stable: Equilibria,
    },
    /// The equilibrium depends on parameters.
    #[error("the force at rest is `{0}`, so the equilibrium depends on parameters")]
    SymbolicEquilibrium(String),
    /// The equilibrium `x = 0` is unstable.
    #[error("{coordinate} = 0 is an unstable equilibrium{}", stable_ones(*coordinate, .stable))]
    Unstable {
        /// The coordinate.
        coordinate: Symbol,
        /// The stable equilibria.
        stable: Equilibria,
        /// Whether motions run through it, over the wells on both sides.
        passed: bool,
    },
    /// A root that is real on one side of the equilibrium alone, so that nothing pulls back from
    /// the other.
    #[error(
        "no motion swings about {coordinate} = 0: for {coordinate} {side} 0 there is no force, because `{term}` has no real value there"
    )]
    OneSided {
        /// The coordinate.
        coordinate: Symbol,
        /// `<` or `>`.
        side: char,
        /// The term with the root, as it was typed where that is known.
        term: String,
        /// The force to write instead of the root, for a force that pulls back on both sides.
        odd: String,
        /// The force to write if it shall be zero where the root has no value; `None` unless
        /// another term pulls back there.
        zero: Option<String>,
    },
    /// The requested position is not a stable equilibrium.
    #[error("{coordinate} = {asked} is no stable equilibrium{}", stable_ones(*coordinate, .stable))]
    NoSuchEquilibrium {
        /// The coordinate.
        coordinate: Symbol,
        /// The requested position.
        asked: Expr,
        /// The stable equilibria.
        stable: Equilibria,
    },
    /// No linear restoring force.
    #[error(
        "the linear restoring force is `{0}`: an expansion needs omega0^2 * x with omega0^2 > 0"
    )]
    NoRestoringForce(Expr),
    /// A term that does not vanish with the small parameter.
    #[error("the term `{term}` does not vanish with the small parameter `{small}`")]
    NotSmall {
        /// The term.
        term: Quotation,
        /// The small parameter.
        small: String,
    },
    /// A term that is no polynomial in coordinate and velocity.
    #[error("the term `{0}` is no polynomial in the coordinate and its velocity")]
    NotPolynomial(Quotation),
    /// No Taylor series.
    #[error(transparent)]
    Taylor(#[from] TaylorError),
    /// More than one parameter could be small.
    #[error("more than one parameter could be the small one: {}", list(.0))]
    AmbiguousSmallParameter(Vec<Symbol>),
    /// The parameter asked for does not occur.
    #[error("there is no parameter `{0}` in the equation")]
    UnknownParameter(Symbol),
}

/// The stable equilibria of a force, as many as a message names.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibria {
    /// Their positions; those without a short closed form as numbers.
    pub positions: Vec<Position>,
    /// The location of further ones; `None` if there are none.
    pub others: Option<FurtherEquilibria>,
}

/// The location of equilibria beyond those that a message names.
#[derive(Clone, Debug, PartialEq)]
pub enum FurtherEquilibria {
    /// Again after each period of the force.
    Every(Expr),
    /// Farther from rest.
    FartherOut,
}

impl fmt::Display for Equilibria {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let positions: Vec<String> = self.positions.iter().map(ToString::to_string).collect();
        formatter.write_str(&positions.join(", "))?;
        match &self.others {
            Some(FurtherEquilibria::Every(period)) => {
                write!(formatter, ", and again every {period}")
            }
            Some(FurtherEquilibria::FartherOut) => formatter.write_str(" and farther out"),
            None => Ok(()),
        }
    }
}

fn stable_ones(coordinate: Symbol, stable: &Equilibria) -> String {
    match stable.positions.is_empty() {
        true => ", and no stable one was found".to_owned(),
        false => format!("; stable ones are at {coordinate} = {stable}"),
    }
}

fn list(symbols: &[Symbol]) -> String {
    symbols.iter().map(|symbol| symbol.name()).collect::<Vec<_>>().join(", ")
}

impl From<ParseError> for OscillatorError {
    fn from(error: ParseError) -> Self {
        Self::Parse(Box::new(error))
    }
}

impl OscillatorError {
    /// The term of the equation that the message names; `None` if it names none.
    pub fn term(&self) -> Option<&str> {
        match self {
            Self::NotSmall { term, .. }
            | Self::NotPolynomial(term)
            | Self::Taylor(TaylorError::NotAnalytic { term, .. }) => Some(term.words()),
            Self::OneSided { term: words, .. } | Self::NonlinearAcceleration(words) => Some(words),
            _ => None,
        }
    }

    /// Advice on what to try; `None` if there is none.
    pub fn help(&self) -> Option<Advice> {
        let either = |words: &str, [first, second]: [Method; 2]| {
            let first = Advice::words(words).choose(Setting::Method(first));
            first.then("` or `").choose(Setting::Method(second)).then("`")
        };
        Some(match self {
            Self::AmbiguousSmallParameter(candidates) => Advice::words("choose one with `")
                .choose(Setting::Small(*candidates.first()?))
                .then("`"),
            Self::NotSmall { .. } => Advice::words("expand in the amplitude instead: `")
                .choose(Setting::Small(AmplitudeConvention::Initial.symbol()))
                .then("`"),
            Self::NotPolynomial(term) | Self::Taylor(TaylorError::NotAnalytic { term, .. })
                if term.expression().contains(Symbol::new("t")) =>
            {
                Advice::words(
                    "in numbers `lindstedt response` finds the steady states of a drive that repeats itself",
                )
            }
            Self::NotPolynomial(term) | Self::Taylor(TaylorError::NotAnalytic { term, .. })
                if term.expression().symbols().iter().all(|symbol| symbol.primes() == 0) =>
            {
                let by_energy = [Method::Hamiltonian, Method::HarmonicBalance];
                match self {
                    Self::NotPolynomial(_) => {
                        let small = Setting::Small(AmplitudeConvention::Initial.symbol());
                        let smooth =
                            Advice::words("where it is smooth, expand it in the amplitude: `")
                                .choose(small);
                        let as_it_is = smooth.then("`; or take the force as it is: `");
                        let [first, second] = by_energy.map(Setting::Method);
                        as_it_is.choose(first).then("` or `").choose(second).then("`")
                    }
                    _ => either("take the force as it is: `", by_energy),
                }
            }
            Self::NotPolynomial(_) => Advice::words("its first order is averaged as it is: `")
                .choose(Setting::Method(Method::Averaging))
                .then("`"),
            Self::NoRestoringForce(force) if force.is_zero() => either(
                "methods that need no linear part: `",
                [Method::ParameterExpansion, Method::HarmonicBalance],
            ),
            Self::OneSided { odd, zero, .. } => Advice::words(match zero {
                Some(zero) => {
                    format!(
                        "write `{odd}` for a force that pulls back on both sides, or `{zero}` for none where the root has no value"
                    )
                }
                None => format!("write `{odd}` for a force that pulls back on both sides"),
            }),
            Self::SymbolicEquilibrium(_) => {
                Advice::words("give numbers for the parameters, or measure x from the equilibrium")
            }
            Self::Unstable { coordinate, stable, .. }
            | Self::BeyondPole { coordinate, stable, .. } => {
                let positions = &stable.positions;
                let positive = positions.iter().find(|position| !position.is_negative());
                let setting = Setting::About {
                    coordinate: *coordinate,
                    position: positive.or(positions.first())?.clone(),
                };
                let advice = Advice::words("choose one with `").choose(setting);
                match self {
                    Self::Unstable { passed: true, .. } => advice
                        .then("`, or `")
                        .choose(Setting::About {
                            coordinate: *coordinate,
                            position: Position::Exact(Expr::zero()),
                        })
                        .then("` for motions over the wells on both sides"),
                    _ => advice.then("`"),
                }
            }
            _ => return None,
        })
    }
}

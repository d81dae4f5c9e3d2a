//! The question: an equation of motion in normal form.
//!
//! In comes an equation as text or as [`Equation`]; out goes an [`Oscillator`], its force taken
//! apart by what its terms do, and expanded about rest. What is not an oscillator, or cannot be
//! expanded, is an [`OscillatorError`] that names the term.
//!
//! ```text
//! m(x) x'' + g(x, x', t) = 0   ->   x'' + f(x, x', t) = 0,   f = g / m
//! f = restoring(x) + inertia(x, x' even) + damping(x, x' odd) + forcing(x, t)
//! ```
//!
//! and, for perturbation methods, the force as a sum of terms
//! `delta^order * coefficient * x^p x'^q` beside the linear `omega0^2 x`, where `delta` is a
//! parameter of the equation or the amplitude itself.

pub(crate) mod corner;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use num_traits::Zero;

use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, Rational};
use crate::expr::{
    Equation, Expr, ExprError, Function, NAMES_OF_ANSWERS, ParseError, Quotation, Typed,
    parse_equation,
};
use crate::series::taylor::{TaylorError, taylor};
use crate::solution::note::Position;
use crate::solution::{Advice, AmplitudeConvention, Definition, Method, Setting};
use crate::symbol::letters::{AMPLITUDE, FIRST_HARMONIC, ResultSymbols};
use crate::symbol::{Symbol, fresh, fresh_stem, phase_beside};
use corner::near_rest;

/// An equation of motion `x'' + force = 0` for one coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Oscillator {
    /// The dependent variable, `x` unless another letter carries the primes.
    pub coordinate: Symbol,
    /// Everything on the left side: the equation is `residual = 0`.
    pub residual: Expr,
    /// `f`, the full force on the left side after division by the coefficient of `x''`.
    pub force: Expr,
    /// The names that are neither the coordinate, its derivatives nor time, in alphabetical order.
    pub parameters: Vec<Symbol>,
    /// The equilibrium about which the motion swings; the stable one nearest to zero where none is
    /// asked for.
    pub about: Option<Expr>,
    /// The terms of the equation as they were typed, for messages.
    pub typed: Typed,
}

/// The force taken apart by what its terms do.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// Terms in the coordinate alone.
    pub restoring: Expr,
    /// Terms even in the velocity: they come from a mass that depends on position and lose no
    /// energy.
    pub inertia: Expr,
    /// Terms odd in the velocity.
    pub damping: Expr,
    /// Terms that contain time.
    pub forcing: Expr,
}

/// The quantity in whose powers an expansion runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SmallParameter {
    /// A parameter of the equation, `eps` say.
    Parameter(Symbol),
    /// The amplitude of the motion.
    Amplitude,
}

/// One term `delta^order * coefficient * x^position * x'^velocity` of the force.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Power of the small parameter, at least one.
    pub order: usize,
    /// Power of the coordinate.
    pub position: u32,
    /// Power of the velocity.
    pub velocity: u32,
    /// The rest, in the parameters; the small parameter itself is left out.
    pub coefficient: Polynomial,
}

/// The force as `omega0^2 x` and terms that vanish with the small parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct PerturbedForce {
    /// `omega0^2`.
    pub linear: Polynomial,
    /// All other terms up to the order asked for.
    pub terms: Vec<Term>,
    /// Constants that are not polynomials and were given names.
    pub definitions: Vec<Definition>,
}

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
    /// The force at rest is not zero, and there is no stable equilibrium near.
    #[error("the force at rest is `{0}`, not zero, and no stable equilibrium was found")]
    NoEquilibrium(String),
    /// The force is infinite at zero, and pulls there without a motion that would pass.
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
    /// The force at rest is not zero, and stable equilibria lie only out of reach of motions from
    /// rest.
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
        /// Advice for a root without a value at zero, at which another term restores.
        zero: Option<String>,
    },
    /// The given position is not a stable equilibrium.
    #[error("{coordinate} = {asked} is no stable equilibrium{}", stable_ones(*coordinate, .stable))]
    NoSuchEquilibrium {
        /// The coordinate.
        coordinate: Symbol,
        /// The given position.
        asked: Expr,
        /// The stable equilibria.
        stable: Equilibria,
    },
    /// The force has no linear restoring part.
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
    /// A term that is not a polynomial in coordinate and velocity.
    #[error("the term `{0}` is no polynomial in the coordinate and its velocity")]
    NotPolynomial(Quotation),
    /// The force has no Taylor series.
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
    /// Positions of the equilibria; numbers for those without a short closed form.
    pub positions: Vec<Position>,
    /// The positions of further equilibria; `None` if there are no others.
    pub others: Option<FurtherEquilibria>,
}

/// Description of further equilibria if there are more than a message names.
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
    /// The term that it names, where it names one of the equation.
    pub fn term(&self) -> Option<&str> {
        match self {
            Self::NotSmall { term, .. }
            | Self::NotPolynomial(term)
            | Self::Taylor(TaylorError::NotAnalytic { term, .. }) => Some(term.words()),
            Self::OneSided { term: words, .. } | Self::NonlinearAcceleration(words) => Some(words),
            _ => None,
        }
    }

    /// Returns advice on what to try; `None` if there is nothing worth trying.
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

impl Parts {
    /// Whether the force is one of the position alone, so that energy is conserved.
    pub fn of_position_alone(&self) -> bool {
        [&self.inertia, &self.damping, &self.forcing].iter().all(|part| part.is_zero())
    }
}

impl Oscillator {
    /// Reads an equation such as `x'' + x + eps*x^3 = 0`.
    ///
    /// # Errors
    /// See [`OscillatorError`].
    ///
    /// ```
    /// # use lindstedt_oscillator as lindstedt;
    /// use lindstedt::Oscillator;
    ///
    /// let van_der_pol = Oscillator::parse("x'' - mu*(1 - x^2)*x' + x = 0")?;
    /// assert_eq!((van_der_pol.coordinate, van_der_pol.parts()?.restoring.to_string()), ("x".into(), "x".to_owned()));
    /// # Ok::<(), lindstedt::oscillator::OscillatorError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, OscillatorError> {
        Self::from_equation(&parse_equation(text)?)
    }

    /// The oscillator of an equation that has been read already.
    ///
    /// # Errors
    /// See [`OscillatorError`].
    pub fn from_equation(equation: &Equation) -> Result<Self, OscillatorError> {
        let coordinate = equation.coordinate;
        let residual = &equation.left - &equation.right;
        let acceleration = coordinate.derivative().derivative();
        let mass = residual.differentiate(acceleration)?.expand()?;
        if mass.is_zero() {
            return Err(OscillatorError::NoAcceleration(coordinate));
        }
        if mass.contains(acceleration) {
            let values = equation.typed.values().enumerate();
            let fast = values.filter(|(_, value)| {
                let slope = value.differentiate(acceleration);
                slope.is_ok_and(|slope| slope.contains(acceleration))
            });
            let numbers: Vec<usize> = fast.map(|(number, _)| number).collect();
            return Err(OscillatorError::NonlinearAcceleration(match numbers.is_empty() {
                true => residual.to_string(),
                false => equation.typed.quote(&numbers),
            }));
        }
        let rest = residual.substitute(acceleration, &Expr::zero())?;
        let force = Expr::divide(&rest, &mass)?;
        // If the force has a pole there, no motion comes to rest; otherwise the mass is the
        // problem.
        let vanishes = at_rest(&mass, coordinate).is_ok_and(|mass| mass.is_zero());
        if vanishes && at_rest(&force, coordinate).is_ok() {
            return Err(OscillatorError::VanishingMass(mass.to_string()));
        }
        let own = [
            coordinate,
            coordinate.derivative(),
            acceleration,
            Symbol::new("t"),
            Symbol::new("pi"),
        ];
        let names: BTreeSet<Symbol> =
            residual.symbols().into_iter().filter(|name| !own.contains(name)).collect();
        Ok(Self {
            coordinate,
            residual,
            force,
            parameters: names.into_iter().collect(),
            about: None,
            typed: equation.typed.clone(),
        })
    }

    /// Returns the equation, to be solved about this equilibrium.
    #[must_use]
    pub fn about(mut self, equilibrium: Expr) -> Self {
        self.about = Some(equilibrium);
        self
    }

    /// Returns the equation with exact values for some of its parameters.
    ///
    /// # Errors
    /// A value at which a term has none.
    pub fn with_values(&self, values: &BTreeMap<Symbol, Expr>) -> Result<Self, OscillatorError> {
        let mut oscillator = self.clone();
        oscillator.force = self.force.substitute_all(values)?;
        oscillator.residual = self.residual.substitute_all(values)?;
        oscillator.typed = self.typed.with_values(values)?;
        oscillator.about = match &self.about {
            Some(place) => Some(place.substitute_all(values)?),
            None => None,
        };
        oscillator.parameters.retain(|name| !values.contains_key(name));
        Ok(oscillator)
    }

    /// Returns the equation with the names that an answer uses for its amplitudes and its
    /// frequency, `A`, `a` and `omega`, kept [apart](Symbol::apart) from those of the answer: the
    /// answer then writes other [`ResultSymbols`].
    ///
    /// # Errors
    /// An expression beyond all limits.
    ///
    /// ```
    /// # use lindstedt_oscillator as lindstedt;
    /// use lindstedt::{Options, Oscillator, solve};
    ///
    /// let duffing = Oscillator::parse("x'' + omega^2*x + eps*x^3 = 0")?.with_own_names_apart()?;
    /// let solution = solve(&duffing, &Options { order: Some(1), ..Options::default() })?;
    /// assert_eq!(solution.formula(), "Omega^2 = omega^2 + 3*eps*A^2/4");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_own_names_apart(&self) -> Result<Self, OscillatorError> {
        let of_answers = |name: &Symbol| NAMES_OF_ANSWERS.contains(&name.name());
        let own: Vec<Symbol> = self.parameters.iter().copied().filter(of_answers).collect();
        let coordinate = Some(self.coordinate).filter(of_answers);
        let states = coordinate.into_iter().flat_map(|name| {
            let velocity = name.derivative();
            [name, velocity, velocity.derivative()]
        });
        let values = own.iter().copied().chain(states);
        let values: BTreeMap<Symbol, Expr> =
            values.map(|name| (name, Expr::from(name.apart()))).collect();
        let mut oscillator = self.with_values(&values)?;
        oscillator.parameters.extend(own.into_iter().map(Symbol::apart));
        oscillator.parameters.sort_unstable();
        if let Some(name) = coordinate {
            oscillator.coordinate = name.apart();
        }
        Ok(oscillator)
    }

    /// The letters of amplitude and frequency in what is derived from this equation: those in force
    /// on this thread, else the ones that the equation leaves free.
    pub fn letters(&self) -> ResultSymbols {
        ResultSymbols::current().unwrap_or_else(|| {
            let own: Vec<Symbol> = self.own_names().collect();
            ResultSymbols::avoiding(&own, self.force.contains(Symbol::new("t")))
        })
    }

    /// The symbol that a person means by this name: one of the equation, or else the one that is
    /// written so in the answer.
    pub fn resolve_symbol(&self, name: Symbol) -> Symbol {
        let own: Vec<Symbol> = self.own_names().collect();
        self.letters().resolve(name, &own)
    }

    /// Parameters whose names look like something else, `e` or `sinx`, each with how that would be
    /// written.
    ///
    /// ```
    /// # use lindstedt_oscillator as lindstedt;
    /// use lindstedt::Oscillator;
    ///
    /// let oscillator = Oscillator::parse("x'' + e*x + sinx = 0")?;
    /// let names = oscillator.misleading_parameters();
    /// assert_eq!(names[1], ("sinx".into(), "the function is `sin(x)`".to_owned()));
    /// # Ok::<(), lindstedt::oscillator::OscillatorError>(())
    /// ```
    pub fn misleading_parameters(&self) -> Vec<(Symbol, String)> {
        let names = self.names();
        let meant = |name: &Symbol| match name.name() {
            "e" => Some("Euler's number is `exp(1)`".to_owned()),
            "i" | "j" => Some("there is no imaginary unit, for all quantities are real".to_owned()),
            text => (1..text.len()).find_map(|end| {
                let (function, argument) = (text.get(..end)?, text.get(end..)?);
                let known = Function::from_name(function).is_some()
                    && names.contains(&Symbol::new(argument));
                known.then(|| format!("the function is `{function}({argument})`"))
            }),
        };
        let parameters = self.parameters.iter();
        parameters.filter_map(|name| Some((*name, meant(name)?))).collect()
    }

    /// The velocity `x'`.
    pub fn velocity(&self) -> Symbol {
        self.coordinate.derivative()
    }

    /// The names that mean something in the equation: parameters, coordinate and time. What a
    /// method introduces is named by [`fresh`] beside them.
    pub fn names(&self) -> Vec<Symbol> {
        let letters = self.letters();
        let letters = letters.renamed().map(|(_, written)| written);
        self.own_names().chain(letters).collect()
    }

    fn own_names(&self) -> impl Iterator<Item = Symbol> {
        let own = [self.coordinate, Symbol::new("t")];
        self.parameters.iter().copied().chain(own)
    }

    /// The name of the phase in what is derived from this equation: `theta`, unless the equation
    /// has that name.
    pub fn phase(&self) -> Symbol {
        phase_beside(&self.names())
    }

    /// The name of the linear frequency in running text: `omega0`, unless the equation uses that
    /// for something else.
    pub fn linear_frequency_name(&self, linear: &Polynomial) -> Symbol {
        let omega0 = Symbol::new("omega0");
        let square = Polynomial::term(Monomial::power_of(omega0, 2), num_traits::One::one());
        if *linear == square { omega0 } else { fresh("omega0", &self.names()) }
    }

    /// The equation in normal form, `x'' + f = 0`.
    pub fn equation(&self) -> Equation {
        let acceleration = Expr::from(self.velocity().derivative());
        Equation {
            left: &acceleration + &self.force,
            right: Expr::zero(),
            coordinate: self.coordinate,
            typed: self.typed.clone(),
        }
    }

    /// Whether the force is one of the position alone, so that its energy gives the period; not
    /// where it cannot be taken apart.
    pub fn of_position_alone(&self) -> bool {
        self.parts().is_ok_and(|parts| parts.of_position_alone())
    }

    /// The terms of the force sorted by kind. A term of several kinds, such as `x'*sin(t)`, counts
    /// as forcing.
    ///
    /// # Errors
    /// The expanded force would be too long.
    pub fn parts(&self) -> Result<Parts, OscillatorError> {
        let velocity = self.velocity();
        let backwards = -&Expr::from(velocity);
        let expanded = self.force.expand()?;
        let (mut restoring, mut inertia, mut damping, mut forcing) =
            (vec![], vec![], vec![], vec![]);
        for term in expanded.terms() {
            if term.contains(Symbol::new("t")) {
                forcing.push(term.clone());
            } else if !term.contains(velocity) {
                restoring.push(term.clone());
            } else if term.substitute(velocity, &backwards)? == *term {
                inertia.push(term.clone());
            } else {
                damping.push(term.clone());
            }
        }
        Ok(Parts {
            restoring: Expr::sum(restoring),
            inertia: Expr::sum(inertia),
            damping: Expr::sum(damping),
            forcing: Expr::sum(forcing),
        })
    }

    /// The quantity in whose powers to expand: `asked`, else `eps`, else the one parameter whose
    /// vanishing leaves `x'' + omega0^2 x`, else the amplitude.
    ///
    /// # Errors
    /// An unknown name, or several parameters that would do.
    pub fn small_parameter(&self, asked: Option<&str>) -> Result<SmallParameter, OscillatorError> {
        if let Some(name) = asked {
            let symbol = self.resolve_symbol(Symbol::new(name));
            return match symbol {
                AMPLITUDE | FIRST_HARMONIC => Ok(SmallParameter::Amplitude),
                _ if self.parameters.contains(&symbol) => Ok(SmallParameter::Parameter(symbol)),
                _ => Err(OscillatorError::UnknownParameter(symbol)),
            };
        }
        let eps = Symbol::new("eps");
        if self.parameters.contains(&eps) {
            return Ok(SmallParameter::Parameter(eps));
        }
        let own = [self.coordinate, self.velocity(), Symbol::new("t")];
        let stiffness = self.stiffness();
        if own.iter().all(|&name| !stiffness.contains(name)) {
            return Ok(SmallParameter::Amplitude);
        }
        let candidates: Vec<Symbol> = self
            .parameters
            .iter()
            .copied()
            .filter(|&parameter| self.is_linear_without(parameter))
            .collect();
        match candidates.as_slice() {
            [] => Ok(SmallParameter::Amplitude),
            [only] => Ok(SmallParameter::Parameter(*only)),
            [first, others @ ..] => {
                match others.iter().all(|other| self.stand_together(*first, *other)) {
                    // Either gives the same orders; a Greek letter is the likelier one.
                    true => Ok(SmallParameter::Parameter(
                        candidates.iter().copied().find(|name| name.is_greek()).unwrap_or(*first),
                    )),
                    false => Err(OscillatorError::AmbiguousSmallParameter(candidates)),
                }
            }
        }
    }

    /// Whether two parameters occur as factors alone, with the same powers in every term, as in
    /// `mu*N*sgn(x')`.
    fn stand_together(&self, one: Symbol, other: Symbol) -> bool {
        let power = |term: &Expr, name: Symbol| {
            let (_, factors) = term.factors();
            let mut powers = factors.iter().filter(|factor| factor.contains(name));
            match powers.next() {
                None => Some(Expr::zero()),
                Some(factor) => {
                    let (base, exponent) = factor.base_and_exponent();
                    let alone = powers.next().is_none() && !exponent.contains(name);
                    (alone && base.as_symbol() == Some(name)).then(|| exponent.clone())
                }
            }
        };
        let alike =
            |term: &Expr| power(term, one).is_some_and(|own| Some(own) == power(term, other));
        self.force.expand().is_ok_and(|force| force.terms().iter().all(alike))
    }

    /// The degree of the force in the coordinate, where it is a polynomial in it.
    ///
    /// # Errors
    /// The expanded force would be too long.
    pub fn polynomial_degree(&self) -> Result<Option<u32>, OscillatorError> {
        let own = [self.coordinate, self.velocity()];
        // The judge asks at every amplitude, and a high power is long when written out.
        if !self.force.contains(own[1])
            && let Some(degree) = self.force.degree_at_sight(self.coordinate)
        {
            return Ok(Some(degree));
        }
        let mut names = NamedConstants::new(self);
        let polynomial =
            self.force.to_polynomial(&mut |constant| names.symbol_of(constant, &own))?;
        let range = polynomial.and_then(|polynomial| polynomial.exponent_range(self.coordinate));
        Ok(range.filter(|range| range.0 >= 0).and_then(|range| u32::try_from(range.1).ok()))
    }

    /// Whether `parameter = 0` leaves `x'' + omega0^2 x = 0`, and the equation is not that already.
    /// The remainder `-Omega^2 x` of a bead on a turning wire does not count.
    fn is_linear_without(&self, parameter: Symbol) -> bool {
        let Ok(rest) =
            self.force.substitute(parameter, &Expr::zero()).and_then(|rest| rest.expand())
        else {
            return false;
        };
        let linear = Expr::divide(&rest, &Expr::from(self.coordinate))
            .and_then(|quotient| quotient.expand());
        linear.is_ok_and(|quotient| {
            let own = [self.coordinate, self.velocity(), Symbol::new("t")];
            let repels = quotient.terms().len() == 1 && quotient.has_leading_minus();
            !quotient.is_zero()
                && !repels
                && own.iter().all(|&name| !quotient.contains(name))
                && quotient != self.stiffness()
        })
    }

    fn stiffness(&self) -> Expr {
        let quotient = Expr::divide(&self.force, &Expr::from(self.coordinate))
            .and_then(|quotient| quotient.expand());
        quotient.unwrap_or_else(|_| self.force.clone())
    }

    /// The force up to `delta^order`, about the equilibrium `x = 0`.
    ///
    /// # Errors
    /// A force at rest, a missing linear restoring force, or a term that is not small, not analytic
    /// or no polynomial.
    ///
    /// ```
    /// # use lindstedt_oscillator as lindstedt;
    /// use lindstedt::{Oscillator, oscillator::SmallParameter};
    ///
    /// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
    /// let force = pendulum.expand(SmallParameter::Amplitude, 4)?;
    /// let powers: Vec<_> = force.terms.iter().map(|term| (term.order, term.position)).collect();
    /// assert_eq!(powers, [(2, 3), (4, 5)]); // -x^3/6 + x^5/120
    /// # Ok::<(), lindstedt::oscillator::OscillatorError>(())
    /// ```
    pub fn expand(
        &self,
        small: SmallParameter,
        order: u32,
    ) -> Result<PerturbedForce, OscillatorError> {
        let force = self.expand_with_any_stiffness(small, order)?;
        if force.lacks_restoring_force() {
            let linear = &force.linear_in_full() * &Expr::from(self.coordinate);
            return Err(OscillatorError::NoRestoringForce(linear));
        }
        Ok(force)
    }

    /// As [`Oscillator::expand`], for methods that need no linear restoring force.
    ///
    /// # Errors
    /// A force at rest, or a term that is not small, not analytic or no polynomial.
    pub fn expand_with_any_stiffness(
        &self,
        small: SmallParameter,
        order: u32,
    ) -> Result<PerturbedForce, OscillatorError> {
        let (position, velocity) = (self.coordinate, self.velocity());
        let force = match small {
            SmallParameter::Parameter(_) => self.force.clone(),
            SmallParameter::Amplitude => near_rest(&self.force, position)?.0,
        };
        let at_rest = at_rest(&force, position).and_then(|force| force.expand());
        if let Ok(force) = at_rest
            && !vanishes_identically(&force)
        {
            return Err(OscillatorError::NoEquilibrium(force.to_string()));
        }
        let zero = Rational::zero();
        let (parts, first) = match small {
            SmallParameter::Parameter(name) => (taylor(&force, &[(name, zero)], order)?, 0),
            SmallParameter::Amplitude => (
                taylor(
                    &force,
                    &[(position, zero.clone()), (velocity, zero)],
                    order.saturating_add(1),
                )?,
                1,
            ),
        };
        // At a removable singularity the force at rest is known by its series alone.
        if let (SmallParameter::Amplitude, Some(at_rest)) = (small, parts.first())
            && !vanishes_identically(at_rest)
        {
            let moves = at_rest.contains(position) || at_rest.contains(velocity);
            return Err(match moves {
                true => OscillatorError::NotPolynomial(at_rest.clone().into()),
                false => OscillatorError::NoEquilibrium(at_rest.to_string()),
            });
        }
        let mut names = NamedConstants::new(self);
        let mut linear = Polynomial::zero();
        let mut terms = Vec::new();
        for (power, part) in parts.iter().enumerate().skip(first) {
            let mut name = |constant: &Expr| names.symbol_of(constant, &[position, velocity]);
            let Some(polynomial) = part.to_polynomial(&mut name)? else {
                return Err(OscillatorError::NotPolynomial(part.clone().into()));
            };
            for (monomial, coefficient) in polynomial.terms() {
                let named =
                    || Expr::from(&Polynomial::term(monomial.clone(), coefficient.clone())).into();
                let exponent = |symbol| u32::try_from(monomial.exponent(symbol));
                let (Ok(p), Ok(q)) = (exponent(position), exponent(velocity)) else {
                    return Err(OscillatorError::NotPolynomial(named()));
                };
                let mut rest = monomial.without(position).without(velocity);
                if let SmallParameter::Parameter(name) = small {
                    rest = rest.without(name);
                }
                let coefficient = Polynomial::term(rest, coefficient.clone());
                match (power - first, p, q) {
                    (0, 1, 0) => linear.accumulate(&coefficient),
                    (0, ..) => {
                        let small = match small {
                            SmallParameter::Parameter(name) => name.to_string(),
                            SmallParameter::Amplitude => AMPLITUDE.to_string(),
                        };
                        return Err(OscillatorError::NotSmall { term: named(), small });
                    }
                    (order, position, velocity) => {
                        terms.push(Term { order, position, velocity, coefficient })
                    }
                }
            }
        }
        Ok(PerturbedForce { linear, terms: merged(terms), definitions: names.definitions })
    }
}

/// Terms with equal powers added up, so that each product of the equation occurs once.
fn merged(terms: Vec<Term>) -> Vec<Term> {
    let mut merged: Vec<Term> = Vec::with_capacity(terms.len());
    for term in terms {
        let key = |term: &Term| (term.order, term.position, term.velocity);
        match merged.iter_mut().find(|known| key(known) == key(&term)) {
            Some(known) => known.coefficient.accumulate(&term.coefficient),
            None => merged.push(term),
        }
    }
    merged
}

/// Whether a constant is zero however it is written, as `sin(c)/cos(c) - tan(c)` is: where no way
/// to write it out says so, tried with numbers for its letters.
fn vanishes_identically(constant: &Expr) -> bool {
    if constant.is_zero() || constant.expand().is_ok_and(|constant| constant.is_zero()) {
        return true;
    }
    let symbols = constant.symbols();
    let tried = [0.137, 0.731, 1.913].map(|scale| {
        let places = symbols.iter().zip(1_u32..);
        let numbers: BTreeMap<Symbol, f64> =
            places.map(|(name, k)| (*name, scale / f64::from(k).sqrt())).collect();
        constant.evaluate_rounded(&|name| Some((*numbers.get(&name)?, 0.0)))
    });
    // One try may be outside of where it has a value.
    let known = tried.into_iter().flatten().filter(|(value, _)| value.is_finite());
    let known: Vec<bool> = known.map(|(value, error)| value.abs() <= error).collect();
    !symbols.is_empty() && known.len() > 1 && known.iter().all(|zero| *zero)
}

fn at_rest(expression: &Expr, coordinate: Symbol) -> Result<Expr, ExprError> {
    expression
        .substitute(coordinate, &Expr::zero())?
        .substitute(coordinate.derivative(), &Expr::zero())
}

/// Names for constants that are not polynomials.
struct NamedConstants {
    taken: Vec<Symbol>,
    definitions: Vec<Definition>,
}

impl NamedConstants {
    fn new(oscillator: &Oscillator) -> Self {
        Self { taken: oscillator.names(), definitions: vec![] }
    }

    /// The symbol of `constant`, unless one of `variables` occurs in it.
    fn symbol_of(&mut self, constant: &Expr, variables: &[Symbol]) -> Option<Symbol> {
        if variables.iter().any(|&variable| constant.contains(variable))
            || constant.contains(Symbol::new("t"))
        {
            return None;
        }
        if let Some(known) =
            self.definitions.iter().find(|definition| definition.meaning == *constant)
        {
            return Some(known.symbol);
        }
        let stem = fresh_stem("c", &self.taken);
        let symbol = Symbol::new(&format!("{stem}{}", self.definitions.len() + 1));
        self.definitions.push(Definition { symbol, meaning: constant.clone() });
        Some(symbol)
    }
}

impl PerturbedForce {
    /// The linear frequency as a single term: a fraction, a product of powers of parameters, or a
    /// symbol with its definition, `omega0` where `names` leave it free.
    pub fn linear_frequency(&self, names: &[Symbol]) -> (Polynomial, Option<Definition>) {
        if let Some(root) = self.linear.single_term_root() {
            return (root, None);
        }
        let symbol = fresh("omega0", names);
        // Negative numbers were refused; nothing else under the root is known to be negative.
        let linear = self.linear_in_full();
        let meaning = linear.sqrt().unwrap_or(linear);
        (
            Polynomial::term(Monomial::power_of(symbol, 1), num_traits::One::one()),
            Some(Definition { symbol, meaning }),
        )
    }

    /// Writes the terms in powers of the linear frequency where a parameter under its root is left
    /// in none of them: of `omega0^2 = g/L` and `g*sin(x)/L` all that is left is `omega0^2 sin(x)`.
    pub(crate) fn write_with_frequency(&mut self, names: &[Symbol]) {
        let (_, Some(root)) = self.linear_frequency(names) else {
            return;
        };
        for letter in self.letters_under_root() {
            let terms = self.terms.iter();
            let written =
                terms.map(|term| self.with_frequency(&term.coefficient, letter, root.symbol));
            if let Some(written) = written.collect::<Option<Vec<Polynomial>>>() {
                for (term, coefficient) in self.terms.iter_mut().zip(written) {
                    term.coefficient = coefficient;
                }
                return;
            }
        }
    }

    /// The parameters of a linear force that is a single product.
    fn letters_under_root(&self) -> Vec<Symbol> {
        let product = self.linear.single_term();
        product.map_or_else(Vec::new, |(monomial, _)| {
            monomial.factors().iter().map(|(symbol, _)| *symbol).collect()
        })
    }

    /// A coefficient that belongs to the force, written as its [terms](Self::write_with_frequency)
    /// are, where that can be done.
    pub(crate) fn written_with_frequency(
        &self,
        coefficient: Polynomial,
        names: &[Symbol],
    ) -> Polynomial {
        let (_, Some(root)) = self.linear_frequency(names) else {
            return coefficient;
        };
        let mut letters = self.letters_under_root().into_iter();
        let written =
            letters.find_map(|letter| self.with_frequency(&coefficient, letter, root.symbol));
        written.unwrap_or(coefficient)
    }

    /// Without a letter of the linear force, whose power says that of the force; `None` if another
    /// of its letters is there more often than before.
    fn with_frequency(
        &self,
        coefficient: &Polynomial,
        letter: Symbol,
        frequency: Symbol,
    ) -> Option<Polynomial> {
        let (linear, number) = self.linear.single_term()?;
        let unit = linear.exponent(letter);
        let mut written = Polynomial::zero();
        for (monomial, own) in coefficient.terms() {
            let power = monomial.exponent(letter) / unit;
            let rest = monomial.product(&linear.power(-power));
            let more =
                |symbol: Symbol| rest.exponent(symbol).abs() > monomial.exponent(symbol).abs();
            if rest.exponent(letter) != 0
                || linear.factors().iter().any(|(symbol, _)| more(*symbol))
            {
                return None;
            }
            let scale = num_traits::pow::Pow::pow(number, -power);
            written.add_term(rest.product(&Monomial::power_of(frequency, 2 * power)), own * scale);
        }
        Some(written)
    }

    /// The coefficient of the linear force, its named constants written out.
    pub(crate) fn linear_in_full(&self) -> Expr {
        let linear = Expr::from(&self.linear);
        let meanings = self.definitions.iter().map(|entry| (entry.symbol, entry.meaning.clone()));
        linear.substitute_all(&meanings.collect()).unwrap_or(linear)
    }

    /// Whether the linear force is known not to restore: nothing, a negative number, or a negative
    /// multiple of one product of parameters, which are taken to be positive.
    fn lacks_restoring_force(&self) -> bool {
        /// Relative size of a sum of constants that is zero but for rounding.
        const ROUNDING: f64 = 1e-14;
        let named = |symbol: &Symbol| self.definitions.iter().any(|entry| entry.symbol == *symbol);
        let parameters: Vec<Symbol> =
            self.linear.symbols().into_iter().filter(|name| !named(name)).collect();
        if self.linear.is_zero() || (!parameters.is_empty() && self.linear.single_term().is_none())
        {
            return self.linear.is_zero();
        }
        let full = self.linear_in_full();
        // Inside a function, as in cos(2*x_e), a parameter may make either sign.
        let not_positive = |value: f64| {
            let numbers = parameters.iter().map(|name| (*name, value)).collect();
            let terms = full.terms().iter();
            let size: f64 =
                terms.filter_map(|term| Some(term.evaluate(&numbers).ok()?.abs())).sum();
            full.evaluate(&numbers).ok().map(|found| found <= ROUNDING * size)
        };
        let known: Vec<bool> = [1.0, 0.1, 0.37, 2.3].into_iter().filter_map(not_positive).collect();
        !known.is_empty() && known.iter().all(|not| *not)
    }
}

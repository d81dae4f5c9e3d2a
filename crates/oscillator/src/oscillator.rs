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
mod error;
mod perturbed;

use std::collections::{BTreeMap, BTreeSet};

use crate::exact::Polynomial;
use crate::exact::polynomial::Monomial;
use crate::expr::{Equation, Expr, ExprError, Function, NAMES_OF_ANSWERS, Typed, parse_equation};
use crate::symbol::letters::{AMPLITUDE, FIRST_HARMONIC, ResultSymbols};
use crate::symbol::{Symbol, fresh, phase_beside};
use perturbed::NamedConstants;

pub use error::{Equilibria, FurtherEquilibria, OscillatorError};
pub use perturbed::{PerturbedForce, Term};

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

    /// Whether the force is one of the position alone, so that its energy gives the period; `false`
    /// where its terms cannot be told apart.
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
                    // Both give the same expansion; a Greek letter is the likelier choice.
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
        // Verification asks for the degree at every amplitude, and expanding a high power is slow.
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
}

fn at_rest(expression: &Expr, coordinate: Symbol) -> Result<Expr, ExprError> {
    expression
        .substitute(coordinate, &Expr::zero())?
        .substitute(coordinate.derivative(), &Expr::zero())
}

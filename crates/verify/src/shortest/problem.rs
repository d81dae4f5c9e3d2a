//! The question of a search: a motion, a quantity of it, and the range of what it depends on.
//!
//! In: an equation, a contact or a mode of several coordinates, what varies (the amplitude, a parameter, or a
//! product such as `eps*A^2` on which the frequency alone depends), its range, and numbers for all else. Out:
//! one motion in one variable, and its true frequency at any value of it.

use std::collections::BTreeMap;

use num_traits::{One as _, Signed as _, Zero as _};

use crate::certificate::{
    LawNotProved, ModeBranch, MotionsOfLaw, StartOfLaw, TrueFrequency, coordinate, restitution,
};
use crate::decimal::decimal;
use crate::exact::Rational;
use crate::exact::rational::{from_f64, to_f64};
use crate::expr::{Expr, ExprError, Function};

use crate::method::{Options, Refusal, inertia, solve};
use crate::modes::{FreeSystem, NonlinearMode, NormalModes};
use crate::oscillator::{Oscillator, OscillatorError};
use crate::parallel::par_map;
use crate::solution::{AmplitudeConvention, Solution};
use crate::symbol::{Symbol, fresh};
use crate::values::Values;
use crate::verify::{VerificationError, mode_frequencies, true_frequency};

/// A quantity that stands in formulas as one name.
#[derive(Clone, Debug, PartialEq)]
pub struct Atom {
    /// Its name.
    pub name: Symbol,
    /// Its meaning in the variable, the variable itself for that; `None` for the restitution of a contact.
    pub meaning: Option<Expr>,
}

/// A family of motions that depends on one variable.
#[derive(Clone, Debug)]
pub enum LawMotion {
    /// Free motions of one coordinate that repeat, with numbers for all parameters but the variable.
    Free {
        /// The equation.
        oscillator: Box<Oscillator>,
        /// The start of the motion; `None` for a limit cycle.
        start: Option<StartOfLaw>,
        /// The solution whose truth is asked for.
        solution: Box<Solution>,
    },
    /// Contacts that lose energy.
    Contact {
        /// `x^n (1 + c x')`, in which the variable is the speed at the touch.
        force: Expr,
        /// The range of the restitution where that is what is asked for.
        restitution: Option<[Rational; 2]>,
    },
    /// Nonlinear normal modes of several coordinates, with numbers for all parameters.
    Mode {
        /// The equations.
        system: Box<FreeSystem>,
        /// The mode.
        mode: Box<NonlinearMode>,
    },
}

/// The motions, the variable and its range.
#[derive(Clone, Debug)]
pub struct LawProblem {
    /// The motions.
    pub motion: LawMotion,
    /// Their equations as text, with the variable in them.
    pub equation: String,
    /// The variable.
    pub variable: Symbol,
    /// The product that the variable stands for, `eps*A^2` say; `None` for the amplitude or a parameter.
    pub meaning: Option<Expr>,
    /// The lower end of the range, not negative.
    pub from: Rational,
    /// The upper end; `None` for infinity.
    pub to: Option<Rational>,
}

/// The reason why no law is searched for.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShortestError {
    /// An empty range, or one that begins below zero.
    #[error("the range {from}:{to} is empty or begins below zero")]
    Range {
        /// Its lower end.
        from: String,
        /// Its upper end.
        to: String,
    },
    /// A force that is not that of a contact.
    #[error("the time of a contact needs a force k*x^n*(1 + c*x'), which loses energy: not {0}")]
    NoContact(Expr),
    /// A quantity on which the time of a contact does not depend alone.
    #[error(
        "`{varying}` does not determine the contact: its time over that without damping depends on {product} alone, or on the restitution e"
    )]
    NotOfContact {
        /// The quantity that varies.
        varying: Expr,
        /// The product of damping and speed.
        product: Expr,
    },
    /// A contact to infinity, or restitutions beyond one.
    #[error("the range of a contact ends at a number, that of its restitution at one")]
    EndOfContact,
    /// The time of the contact is not enclosed.
    #[error("the time of the contact is not known on the whole range: {0}")]
    Contact(LawNotProved),
    /// The mode has no formula from which its motions are followed.
    #[error("mode {number} has no formula: {reason}")]
    Mode {
        /// Its number.
        number: usize,
        /// The reason.
        reason: String,
    },
    /// A mode with another variable than its amplitude.
    #[error("of a mode the amplitude `{0}` varies, not `{1}`")]
    NotAmplitude(Symbol, Expr),
    /// The name that varies is neither the amplitude nor a parameter.
    #[error("`{0}` is neither the amplitude `{1}` nor a parameter of the equation")]
    NoVariable(Expr, Symbol),
    /// A law that is to be exact at rest, of a truth without a series of fractions there.
    #[error("the series of the truth in {0} has no coefficients that are fractions")]
    NoSeries(Symbol),
    /// A motion with damping or a drive.
    #[error(
        "laws on a range are of free motions that repeat: without damping and without a drive, or on a limit cycle"
    )]
    NotPeriodic,
    /// The frequency depends on more than the product.
    #[error(
        "the frequency does not depend on `{product}` alone: at that value it still changes with {still}"
    )]
    NotAlone {
        /// The product.
        product: Expr,
        /// The letter on which it depends besides.
        still: Symbol,
    },
    /// Values are missing.
    #[error("values are needed for: {}", .0.iter().map(|name| name.written()).collect::<Vec<_>>().join(", "))]
    Missing(Vec<Symbol>),
    /// A value for a name that has none here.
    #[error("`{0}` does not occur in the question besides the range")]
    Unknown(Symbol),
    /// A quantity of formulas with letters other than the variable, or without a value.
    #[error("`{0}` is no quantity of `{1}` with a finite value on the whole range")]
    Atom(Expr, Symbol),
    /// The equation has no formula.
    #[error(transparent)]
    Refused(#[from] Box<Refusal>),
    /// An equation that cannot be written.
    #[error(transparent)]
    Equation(#[from] Box<OscillatorError>),
    /// An expression that cannot be written.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// There is no true motion at a value of the range.
    #[error("at {variable} = {at}: {reason}")]
    Truth {
        /// The variable.
        variable: Symbol,
        /// Its value.
        at: String,
        /// The reason.
        reason: Box<VerificationError>,
    },
    /// The quantity is not positive on the range.
    #[error(
        "the frequency is zero or infinite at {variable} = {at}, and no relative error is bounded there"
    )]
    Vanishes {
        /// The variable.
        variable: Symbol,
        /// Its value.
        at: String,
    },
    /// The search was interrupted before the truth was known.
    #[error("the search was interrupted before the true frequency was known")]
    Stopped,
}

impl ShortestError {
    /// A way forward; `None` if the message names it.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Range { .. } => Some("write --range A=0:2.8, or --range A=0:inf".to_owned()),
            Self::NoVariable(_, amplitude) => Some(format!(
                "a range is of the amplitude, --range {amplitude}=0:1, or of a parameter"
            )),
            Self::NotAlone { still, .. } => Some(format!(
                "give a number for {still} by --at, and a range to the other one alone"
            )),
            Self::Missing(names) => {
                let values: Vec<String> =
                    names.iter().map(|name| format!("--at {name}=1")).collect();
                Some(format!("add {}", values.join(" ")))
            }
            Self::NoSeries(_) => Some("leave --exact-at-rest out".to_owned()),
            Self::NoContact(_) => Some(
                "write it as x'' + k*x^(3/2)*(1 + lambda*x') = 0, with --range lambda*v=0:5 or e=0.2:1"
                    .to_owned(),
            ),
            Self::NotOfContact { product, .. } => {
                Some(format!("write --range \"{product}=0:5\", or --range e=0.2:1"))
            }
            Self::Contact(_) => Some(
                "begin the range at a larger restitution, or end it at a smaller speed: contacts that stop nearly all of the speed have no enclosure"
                    .to_owned(),
            ),
            Self::NotAmplitude(amplitude, _) => {
                Some(format!("write --range {amplitude}=0:1, and numbers by --at"))
            }
            Self::NotPeriodic => Some(
                "leave the damping and the drive out, or derive the decay: `lindstedt derive`"
                    .to_owned(),
            ),
            Self::Atom(..) => {
                Some("write it in the variable alone, such as --atom \"cos(A/2)\"".to_owned())
            }
            Self::Truth { variable, .. } => Some(format!(
                "the whole range has to be of one family of periodic motions: end it before that value of {variable}"
            )),
            Self::Vanishes { variable, .. } => {
                Some(format!("begin or end the range beside that value of {variable}"))
            }
            _ => None,
        }
    }
}

/// The true frequency at places of the range.
#[derive(Clone, Debug)]
pub(super) struct TrueFrequencies {
    /// The values of the variable, in ascending order.
    pub(super) places: Vec<f64>,
    /// omega there; of a contact T_0/T.
    pub(super) frequencies: Vec<f64>,
    /// The restitution of a contact there; nothing of other motions.
    pub(super) restitutions: Vec<f64>,
}

impl LawProblem {
    /// The problem of an equation whose range is that of an amplitude, a parameter or a product of
    /// powers of both.
    ///
    /// # Errors
    /// [`ShortestError`].
    pub fn new(
        oscillator: &Oscillator,
        varying: &Expr,
        (from, to): (&Rational, Option<&Rational>),
        at: &Values,
    ) -> Result<Self, ShortestError> {
        ends(from, to)?;
        let solved =
            |oscillator: &Oscillator| solve(oscillator, &Options::default()).map_err(Box::new);
        let general = solved(oscillator)?;
        if general.response.is_some() || (general.slow().is_some() && general.limit_cycle.is_none())
        {
            return Err(ShortestError::NotPeriodic);
        }
        let amplitude = AmplitudeConvention::Initial.symbol();
        // The name by which the amplitude goes where the equation has its letter for something else.
        let written = Symbol::new(amplitude.written());
        let is_cycle = general.limit_cycle.is_some();
        let is_parameter = |name: &Symbol| oscillator.parameters.contains(name);
        let (oscillator, variable, start, meaning) = match varying.as_symbol() {
            Some(name) if name == amplitude && !is_cycle => {
                (oscillator.clone(), written, Some(StartOfLaw::Variable), None)
            }
            Some(name) if is_parameter(&name) && is_cycle => (oscillator.clone(), name, None, None),
            Some(name) if is_parameter(&name) => {
                let exact = at.iter().find(|(given, _)| *given == amplitude);
                let exact = exact.and_then(|(_, value)| value.as_number().cloned());
                let start = exact.ok_or_else(|| ShortestError::Missing(vec![amplitude]))?;
                (oscillator.clone(), name, Some(StartOfLaw::Fixed(start.abs())), None)
            }
            Some(_) => return Err(ShortestError::NoVariable(varying.clone(), amplitude)),
            None => {
                let (scaled, variable) = scaled(oscillator, varying, amplitude)?;
                let start = Some(StartOfLaw::Fixed(Rational::one()));
                let meaning = varying.substitute(amplitude, &Expr::from(written))?;
                (scaled, variable, start, Some(meaning))
            }
        };
        let needed: Vec<Symbol> =
            oscillator.parameters.iter().copied().filter(|name| *name != variable).collect();
        let gives_amplitude = |name: &Symbol| {
            *name == amplitude && meaning.is_none() && matches!(start, Some(StartOfLaw::Fixed(_)))
        };
        if let Some((name, _)) =
            at.iter().find(|(name, _)| !needed.contains(name) && !gives_amplitude(name))
        {
            return Err(ShortestError::Unknown(name));
        }
        let (values, _) = at.split(&needed);
        let missing: Vec<Symbol> =
            needed.iter().copied().filter(|name| !values.contains_key(name)).collect();
        if !missing.is_empty() {
            return Err(ShortestError::Missing(missing));
        }
        let oscillator = Box::new(oscillator.with_values(&values).map_err(Box::new)?);
        let solution = Box::new(solved(&oscillator)?);
        let equation = format!("{} = 0", oscillator.residual);
        let motion = LawMotion::Free { oscillator, start, solution };
        Ok(Self { motion, equation, variable, meaning, from: from.clone(), to: to.cloned() })
    }

    /// The problem of the backbone of a normal mode: its frequency against its amplitude. The system has
    /// numbers for all parameters.
    ///
    /// # Errors
    /// [`ShortestError`].
    pub fn of_mode(
        modes: &NormalModes,
        number: usize,
        varying: &Expr,
        (from, to): (&Rational, Option<&Rational>),
    ) -> Result<Self, ShortestError> {
        let to = ends(from, to)?;
        let variable = modes.amplitude.symbol();
        if varying.as_symbol() != Some(variable) {
            return Err(ShortestError::NotAmplitude(variable, varying.clone()));
        }
        let parameters = &modes.system.equations.parameters;
        if !parameters.is_empty() {
            return Err(ShortestError::Missing(parameters.clone()));
        }
        let none = |reason: String| ShortestError::Mode { number, reason };
        let mode = modes.modes.iter().find(|mode| match mode {
            Ok(mode) => mode.number == number,
            Err(_) => modes.modes.len() == 1,
        });
        let mode = match mode {
            Some(Ok(mode)) => mode.clone(),
            Some(Err(error)) => return Err(none(error.to_string())),
            None => return Err(none(format!("there are {} modes", modes.count))),
        };
        let sides = modes.system.equations.equations.iter();
        let equations = sides.map(|(left, right)| format!("{left} = {right}"));
        Ok(Self {
            equation: equations.collect::<Vec<_>>().join("; "),
            motion: LawMotion::Mode {
                system: Box::new(modes.system.clone()),
                mode: Box::new(mode),
            },
            variable,
            meaning: None,
            from: from.clone(),
            to,
        })
    }

    /// The motions of a certificate of the law, those of one coordinate in the coordinate
    /// [`x`](coordinate), measured from the equilibrium.
    ///
    /// # Errors
    /// Motions of which no law is proved.
    pub(super) fn of_certificate(&self) -> Result<MotionsOfLaw, LawNotProved> {
        match &self.motion {
            LawMotion::Free { start: None, .. } => Err(LawNotProved::LimitCycle),
            LawMotion::Free { oscillator, start: Some(start), solution } => {
                let place = Expr::from(coordinate()) + &solution.equilibrium;
                let centred = |of: &Expr| of.substitute(oscillator.coordinate, &place);
                let (mass, force) = match inertia::mass_and_force(oscillator) {
                    Some([mass, force]) => (Some(centred(&mass)?), force),
                    None => (None, oscillator.force.clone()),
                };
                let (force, start) = (centred(&force)?, start.clone());
                Ok(MotionsOfLaw::Coordinate { force, mass, start })
            }
            LawMotion::Contact { force, .. } => Ok(MotionsOfLaw::Coordinate {
                force: force.clone(),
                mass: None,
                start: StartOfLaw::Variable,
            }),
            LawMotion::Mode { system, mode } => {
                Ok(MotionsOfLaw::Mode(ModeBranch::new(system, mode, &self.from)?))
            }
        }
    }

    /// The start of a free motion of one coordinate.
    pub fn start(&self) -> Option<&StartOfLaw> {
        match &self.motion {
            LawMotion::Free { start, .. } => start.as_ref(),
            _ => None,
        }
    }

    /// The letter of what has a range: the variable, or the restitution of a contact.
    pub fn abscissa(&self) -> Symbol {
        match &self.motion {
            LawMotion::Contact { restitution: Some(_), .. } => restitution(),
            _ => self.variable,
        }
    }

    /// The letters of the coordinates.
    pub fn coordinates(&self) -> Vec<Symbol> {
        match &self.motion {
            LawMotion::Free { oscillator, .. } => vec![oscillator.coordinate],
            LawMotion::Contact { .. } => vec![],
            LawMotion::Mode { system, .. } => system.equations.coordinates.clone(),
        }
    }

    /// The letter of the amplitude and its value where a parameter varies.
    pub(super) fn amplitude(&self) -> Option<(Symbol, &Rational)> {
        match self.start() {
            Some(StartOfLaw::Fixed(start)) => Some((AmplitudeConvention::Initial.symbol(), start)),
            _ => None,
        }
    }

    /// The value of the variable at a part of the range, from zero to one; of a range to infinity half
    /// of the parts are below the larger of one and its lower end.
    fn place(&self, part: f64) -> f64 {
        let from = to_f64(&self.from);
        match &self.to {
            Some(to) => from + (to_f64(to) - from) * part,
            None => from + part / (1.0 - part) * from.max(1.0),
        }
    }

    /// The true frequency at so many places, which are closer to each other at the ends of the range.
    /// The values of a contact come from its enclosure.
    pub(super) fn true_frequencies(
        &self,
        count: usize,
        enclosed: Option<&TrueFrequency>,
    ) -> Result<TrueFrequencies, ShortestError> {
        /// Parts of the range that stand for its ends where these have no motion.
        const LEAST: f64 = 1e-6;
        const MOST: f64 = 1.0 - 1e-8;
        let places: Vec<f64> = (0..count)
            .map(|i| {
                let part = (std::f64::consts::PI * i as f64 / (count - 1) as f64).cos();
                let part = (1.0 - part) / 2.0;
                let least = if self.from.is_zero() { LEAST } else { 0.0 };
                self.place(part.max(least).min(if self.to.is_none() { MOST } else { 1.0 }))
            })
            .collect();
        let mut restitutions = vec![];
        let frequencies = match &self.motion {
            LawMotion::Free { oscillator, start, solution } => {
                let motion = (&**oscillator, start.as_ref(), &**solution);
                let found = par_map(&places, |&place| self.true_frequency(motion, place));
                found.into_iter().collect::<Result<_, _>>()?
            }
            LawMotion::Contact { .. } => {
                let known = places.iter().map(|&place| enclosed?.at(place));
                let known: Option<Vec<[f64; 2]>> = known.collect();
                let known = known.ok_or(ShortestError::Stopped)?;
                restitutions = known.iter().map(|[_, e]| *e).collect();
                known.iter().map(|[duration, _]| duration.recip()).collect()
            }
            LawMotion::Mode { system, mode } => {
                mode_frequencies(system, mode, &places).map_err(|reason| {
                    let at = places.last().copied().map_or_else(String::new, decimal);
                    ShortestError::Truth { variable: self.variable, at, reason: Box::new(reason) }
                })?
            }
        };
        Ok(TrueFrequencies { places, frequencies, restitutions })
    }

    /// The true frequency of a free motion at a value of the variable.
    ///
    /// # Errors
    /// No periodic motion there.
    fn true_frequency(
        &self,
        (oscillator, start, solution): (&Oscillator, Option<&StartOfLaw>, &Solution),
        place: f64,
    ) -> Result<f64, ShortestError> {
        let at = || decimal(place);
        let _letters = solution.letters().in_force();
        let mut values = Values::default();
        let mut insert = |name: Symbol, value: Rational| {
            // A number is a value, and each name is given once.
            let _ = values.insert(name, Expr::number(value));
        };
        let exact = from_f64(place).unwrap_or_else(Rational::zero);
        match start {
            Some(StartOfLaw::Fixed(start)) => {
                insert(AmplitudeConvention::Initial.symbol(), start.clone());
                insert(self.variable, exact);
            }
            Some(StartOfLaw::Variable) => insert(AmplitudeConvention::Initial.symbol(), exact),
            None => insert(self.variable, exact),
        }
        let frequency = true_frequency(oscillator, solution, &values).map_err(|reason| {
            ShortestError::Truth { variable: self.variable, at: at(), reason: Box::new(reason) }
        })?;
        match frequency.is_normal() {
            true => Ok(frequency.abs()),
            false => Err(ShortestError::Vanishes { variable: self.variable, at: at() }),
        }
    }

    /// The quantities of which formulas are made where none are given: the variable, for forces of sines
    /// the cosine of half an amplitude, which the energy of a pendulum offers, and for contacts the
    /// restitution; that alone where it is what has a range.
    pub fn usual_atoms(&self) -> Vec<Atom> {
        let variable = Expr::from(self.variable);
        let own = Atom { name: self.variable, meaning: Some(variable.clone()) };
        match &self.motion {
            LawMotion::Contact { restitution: asked, .. } => {
                let restitution = Atom { name: restitution(), meaning: None };
                match asked {
                    Some(_) => vec![restitution],
                    None => vec![own, restitution],
                }
            }
            LawMotion::Mode { .. } => vec![own],
            LawMotion::Free { oscillator, start, .. } => {
                let force = &oscillator.force;
                let waves = [Function::Sin, Function::Cos];
                let has_waves = waves.iter().any(|wave| force.contains_function(*wave));
                if *start != Some(StartOfLaw::Variable) || !has_waves {
                    return vec![own];
                }
                let half = Expr::divide(&variable, &Expr::from(2)).and_then(|half| half.cos());
                let name = fresh("c", &[self.variable, oscillator.coordinate]);
                let cosine = half.ok().map(|meaning| Atom { name, meaning: Some(meaning) });
                std::iter::once(own).chain(cosine).collect()
            }
        }
    }
}

/// The upper end of a range, `None` for infinity, if the range is one.
pub(super) fn ends(
    from: &Rational,
    to: Option<&Rational>,
) -> Result<Option<Rational>, ShortestError> {
    if from.is_negative() || to.is_some_and(|to| to <= from) {
        let to = to.map_or("inf".to_owned(), Rational::to_string);
        return Err(ShortestError::Range { from: from.to_string(), to });
    }
    Ok(to.cloned())
}

/// The equation of `x = A y` in which a product with a parameter stands for that parameter, and its name.
fn scaled(
    oscillator: &Oscillator,
    product: &Expr,
    amplitude: Symbol,
) -> Result<(Oscillator, Symbol), ShortestError> {
    let no_variable = || ShortestError::NoVariable(product.clone(), amplitude);
    let symbols = product.symbols();
    let parameter = oscillator.parameters.iter().find(|name| symbols.contains(name));
    let parameter = *parameter.ok_or_else(no_variable)?;
    let taken: Vec<Symbol> =
        oscillator.parameters.iter().copied().chain([amplitude, oscillator.coordinate]).collect();
    let variable = fresh("s", &taken);
    // The product is linear in the parameter: eps = s/(the product without eps).
    let slope = product.differentiate(parameter)?;
    if slope.is_zero() || slope.contains(parameter) || !slope.contains(amplitude) {
        return Err(no_variable());
    }
    let meaning = Expr::divide(&Expr::from(variable), &slope)?;
    let x = Expr::from(oscillator.coordinate);
    let size = Expr::from(amplitude);
    let values = BTreeMap::from([(parameter, meaning), (oscillator.coordinate, &size * &x)]);
    let force = Expr::divide(&oscillator.force.substitute_all(&values)?, &size)?.expand()?;
    let others = oscillator.parameters.iter().copied();
    let still =
        others.chain([amplitude]).find(|name| symbols.contains(name) && force.contains(*name));
    if let Some(still) = still {
        return Err(ShortestError::NotAlone { product: product.clone(), still });
    }
    let acceleration = oscillator.coordinate.derivative().derivative();
    let scaled = Oscillator::parse(&format!("{acceleration} + {force} = 0")).map_err(Box::new)?;
    Ok((scaled, variable))
}

//! Hill's equation: linear, with coefficients that are periodic in time, such as Mathieu's.
//!
//! References: A. H. Nayfeh and D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, chapter 5; W.
//! Magnus and S. Winkler, *Hill's Equation*, Wiley 1966; M. Abramowitz and I. A. Stegun, *Handbook
//! of Mathematical Functions*, chapter 20, for the names a_n and b_n.
//!
//! ```text
//! x'' + c(t) x' + (r delta + p(t)) x = 0,   c, p of the period T = 2 pi/Omega, small with eps
//! ```
//!
//! In comes an [`Oscillator`] of this form; out go its transition curves `delta(eps)`, exact to an
//! order: there a motion of period T or 2 T exists, and between two of them that belong together
//! rest is unstable. They are verified by Floquet's multipliers of the equation.

mod curves;
mod periodic;
mod truth;

use std::collections::BTreeSet;

use num_traits::{One, Zero};
use thiserror::Error;

use crate::exact::rational::ratio;
use crate::exact::{Monomial, POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::{Equation, Expr, ExprError};
use crate::oscillator::Oscillator;
use crate::series::FourierSeries;
use crate::solution::Sum;
use crate::symbol::Symbol;

pub use curves::{TransitionCurve, WavesOfMotion};
pub use periodic::Frequency;
pub use truth::{Chart, JudgedCurve, chart, judge};

/// The highest order that is derived.
pub const HIGHEST_ORDER: u32 = 60;

/// The largest number of tongues that are derived, not counting number 0.
pub const MOST_TONGUES: usize = 20;

/// Order, number of tongues and unknowns of a derivation.
#[derive(Clone, Debug, PartialEq)]
pub struct HillOptions {
    /// Highest power of the small parameters, all together, that is kept.
    pub order: u32,
    /// The tongues 0, 1, ... up to this one.
    pub tongues: usize,
    /// The small parameters, if they are named; empty otherwise.
    pub small: Vec<String>,
    /// The symbol for which the curves are solved, in the mean stiffness or the frequency; if
    /// `None`, it is chosen by the form of the equation.
    pub solve_for: Option<String>,
}

impl Default for HillOptions {
    /// Order 6, the tongues 0 to 3.
    fn default() -> Self {
        Self { order: 6, tongues: 3, small: vec![], solve_for: None }
    }
}

/// The quantity that a transition curve gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknown {
    /// A power of a symbol that occurs in one term of the mean stiffness and nowhere else.
    Stiffness {
        /// The letter.
        name: Symbol,
        /// Its power there, not zero.
        power: i32,
    },
    /// The square of the frequency, which has this symbol.
    Frequency(Symbol),
}

impl Unknown {
    /// The letter.
    pub fn symbol(self) -> Symbol {
        match self {
            Self::Stiffness { name, .. } | Self::Frequency(name) => name,
        }
    }

    /// The power of the symbol that the curves give: 1 for `delta`, 2 for `Omega^2`.
    pub fn power(self) -> i32 {
        match self {
            Self::Stiffness { power, .. } => power,
            Self::Frequency(_) => 2,
        }
    }

    /// The left side of a curve: `delta`, `Omega^2`.
    pub fn given(self) -> Polynomial {
        Polynomial::term(Monomial::power_of(self.symbol(), self.power()), Rational::one())
    }
}

/// The curves of an equation on which it changes between stable and unstable.
#[derive(Clone, Debug, PartialEq)]
pub struct TransitionCurves {
    /// The equation, as it was understood.
    pub equation: Equation,
    /// The quantity that the curves give.
    pub unknown: Unknown,
    /// The small parameters; the order counts their powers together.
    pub small: Vec<Symbol>,
    /// The highest power kept.
    pub order: u32,
    /// The parameters of the equation.
    pub parameters: Vec<Symbol>,
    /// The symbol W of the dimensionless time `tau = W*t` in which the coefficients below are
    /// written; `None` if they are functions of the time of the equation.
    pub time_scale: Option<Symbol>,
    /// The frequency of the coefficients.
    pub frequency: Frequency,
    /// `c(t)`.
    pub damping: Expr,
    /// The coefficient of the coordinate.
    pub stiffness: Expr,
    /// The highest harmonic of both, in halves of their frequency.
    pub highest_harmonic: usize,
    /// The curves, those of tongue 0 first, the lower one of a pair before the upper one for
    /// positive small parameters.
    pub curves: Vec<TransitionCurve>,
}

impl TransitionCurves {
    /// A polynomial of a curve, lowest order in the small parameters first.
    pub fn ordered(&self, polynomial: &Polynomial) -> Sum {
        Sum::new(polynomial, false, |monomial| {
            self.small.iter().map(|name| monomial.exponent(*name)).sum()
        })
    }

    /// The frequency of the coefficients in the time of the equation.
    pub fn driving_frequency(&self) -> Expr {
        let frequency = Expr::from(&self.frequency.polynomial());
        self.time_scale.map_or(frequency.clone(), |name| &frequency * &Expr::from(name))
    }

    /// T, the period of the coefficients, in the time of the equation.
    ///
    /// # Errors
    /// An expression beyond all limits.
    pub fn period(&self) -> Result<Expr, ExprError> {
        let turn = &Expr::number(ratio(2, 1)) * &Expr::pi();
        Expr::divide(&turn, &self.driving_frequency())
    }

    /// The names of the small parameters: `eps, zeta`.
    pub fn small_in_words(&self) -> String {
        let names: Vec<&str> = self.small.iter().map(|name| name.name()).collect();
        names.join(", ")
    }
}

impl TransitionCurve {
    /// The right side of the curve.
    ///
    /// # Errors
    /// An expression beyond all limits.
    pub fn expression(&self) -> Result<Expr, ExprError> {
        let middle = Expr::from(&self.middle);
        let Some(root) = &self.under_root else {
            return Ok(middle);
        };
        let root = Expr::from(root).sqrt()?;
        Ok(if self.upper { &middle + &root } else { &middle - &root })
    }
}

/// The reason why there are no transition curves, or no verification of them.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum HillError {
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// A term that is not linear in the coordinate.
    #[error(
        "the stability of rest is that of the linear equation, but the term `{0}` is not linear"
    )]
    NotLinear(String),
    /// A term without the coordinate.
    #[error("the term `{0}` drives the motion and has no part in the stability of rest")]
    Drive(String),
    /// A coefficient that is not a finite Fourier series.
    #[error(
        "`{0}` is no sum of waves cos(m*Omega*t), sin(m*Omega*t) of one period, with products of letters before them"
    )]
    NotPeriodic(String),
    /// All coefficients are constant.
    #[error("no coefficient depends on the time, so there are no transition curves")]
    Constant,
    /// There is no symbol to solve for.
    #[error("there is no letter to solve for: neither the mean stiffness nor the frequency is one")]
    NoUnknown,
    /// There are several symbols to solve for.
    #[error("the mean stiffness has the letters {0}: which of them do the curves give?")]
    SeveralUnknowns(String),
    /// A symbol that cannot be solved for.
    #[error("`{0}` is neither a letter of the mean stiffness alone nor the frequency")]
    NotAnUnknown(String),
    /// A frequency that remains in several coefficients even in the time that it scales.
    #[error(
        "the curves cannot be solved for `{0}`: with the time tau = {0}*t it still stands in several terms of the coefficients, {1}"
    )]
    InSeveralTerms(Symbol, String),
    /// A mean stiffness that is not a single positive term although the frequency is the unknown.
    #[error(
        "the mean stiffness is `{0}`, and the frequency can be found beside a single positive term alone"
    )]
    Stiffness(String),
    /// A coefficient that is a number.
    #[error("the coefficient of `{0}` is a number, and the expansion is in a small letter")]
    NumberIsSmall(String),
    /// Several parameters might be small, and none was named.
    #[error("which of {0} are small?")]
    SeveralSmall(String),
    /// A parameter that is to be small but does not occur.
    #[error("`{0}` is no parameter of the equation")]
    UnknownSmall(String),
    /// A term that does not vanish with the small parameters.
    #[error("the term `{0}` does not vanish with {1}")]
    NotSmall(String, String),
    /// An order beyond the limits.
    #[error(
        "the order is a whole number from 1 to {HIGHEST_ORDER}, the tongues are 0 to {MOST_TONGUES}"
    )]
    Limits,
    /// Parameters without a value.
    #[error("no value for {0}")]
    Missing(String),
    /// A value for a symbol that does not occur, or that the curves give.
    #[error("there is a value for `{0}`, which {1}")]
    Unknown(Symbol, &'static str),
    /// No positive frequency.
    #[error("the frequency of the coefficients is {0} there, and must be positive")]
    Frequency(f64),
    /// Coefficients that have no finite value, or are too large.
    #[error(
        "the coefficients have no finite value there, or are too large for {} harmonics",
        truth::MOST_HARMONICS
    )]
    Coefficients,
    /// The determinant and the integrated motion do not agree.
    #[error(
        "no multiplier of the integrated motion confirms the curve {0}: nothing is judged there"
    )]
    NotConfirmed(String),
}

impl HillError {
    /// The term it names, as it was typed.
    pub fn term(&self) -> Option<&str> {
        match self {
            Self::NotLinear(term)
            | Self::Drive(term)
            | Self::NotPeriodic(term)
            | Self::NumberIsSmall(term) => Some(term),
            _ => None,
        }
    }

    /// Returns advice on what to try instead, in a sentence; `None` if there is none.
    pub fn help(&self) -> Option<String> {
        let words = match self {
            Self::NotLinear(_) => {
                "put its linear part in its place, such as x for sin(x); leave it out where it has none"
            }
            Self::Drive(_) => "leave it out",
            Self::NotPeriodic(_) => {
                "write the coefficient as in `(delta + eps*cos(2*t))*x`, phases written out: cos(2*t + b) = cos(b)*cos(2*t) - sin(b)*sin(2*t)"
            }
            Self::Constant => "for a constant stiffness: `lindstedt derive`",
            Self::NoUnknown => {
                "write the equation with a letter, as in `x'' + (delta + eps*cos(2*t))*x` or with cos(Omega*t)"
            }
            Self::SeveralUnknowns(_) | Self::NotAnUnknown(_) | Self::InSeveralTerms(..) => {
                "choose one with `--for NAME`"
            }
            Self::Stiffness(_) => "choose a letter of the mean stiffness with `--for NAME`",
            Self::NumberIsSmall(_) => {
                "write `eps*cos(2*t)` and give its number with `--at eps=0.2`"
            }
            Self::SeveralSmall(_) | Self::UnknownSmall(_) | Self::NotSmall(..) => {
                "name those that are small with `--small NAME`, repeated"
            }
            Self::Missing(_) => "give it with --at NAME=VALUE",
            Self::NotConfirmed(_) | Self::Coefficients => "take smaller values, or fewer tongues",
            Self::Expression(_) | Self::Limits | Self::Unknown(..) | Self::Frequency(_) => {
                return None;
            }
        };
        Some(words.to_owned())
    }
}

/// Hill's equation, separated into its coefficients.
struct Hill {
    unknown: Unknown,
    /// The coefficient of the unknown power in the mean stiffness; zero if the frequency is the
    /// unknown.
    factor: Polynomial,
    /// The part of the mean stiffness that is neither the unknown nor small.
    constant: Polynomial,
    small: Vec<Symbol>,
    frequency: Frequency,
    /// Highest harmonic of the coefficients, in halves of the frequency.
    highest_harmonic: usize,
    /// `p` and `c` in `phi = Omega*t/2`, the parts of degree 1, 2, ... in the small parameters.
    graded: Vec<[FourierSeries<Polynomials>; 2]>,
}

/// The transition curves of an equation, exact to an order in the small parameters.
///
/// The cost is, for each tongue and order, that of the products of the coefficients with the orders
/// before.
///
/// # Errors
/// [`HillError`].
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::Oscillator;
/// use lindstedt::hill::{HillOptions, transition_curves};
///
/// let mathieu = Oscillator::parse("x'' + (delta + eps*cos(2*t))*x = 0")?;
/// let curves = transition_curves(&mathieu, &HillOptions { order: 2, tongues: 1, ..HillOptions::default() })?;
/// let formulas: Vec<String> = curves.curves.iter().map(|curve| format!("{}: {}", curve.name, curve.middle)).collect();
/// assert_eq!(formulas, ["a0: -eps^2/8", "a1: 1 - eps/2 - eps^2/32", "b1: 1 + eps/2 - eps^2/32"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn transition_curves(
    oscillator: &Oscillator,
    options: &HillOptions,
) -> Result<TransitionCurves, HillError> {
    if options.order == 0 || options.order > HIGHEST_ORDER || options.tongues > MOST_TONGUES {
        return Err(HillError::Limits);
    }
    let coefficients = linear_coefficients(oscillator)?;
    let time_scale = time_scale(&coefficients, options.solve_for.as_deref());
    let [damping, stiffness] = match time_scale {
        None => coefficients,
        Some(name) => in_scaled_time(&coefficients, name)?,
    };
    let hill = Hill::new(oscillator, [&damping, &stiffness], time_scale, options)?;
    let mut curves = Vec::new();
    for tongue in 0..=options.tongues {
        // Without the time no motion of the period 0 has a frequency.
        if tongue == 0 && matches!(hill.unknown, Unknown::Frequency(_)) {
            continue;
        }
        curves.extend(curves::of_tongue(&hill, tongue, options.order)?);
    }
    Ok(TransitionCurves {
        equation: oscillator.equation(),
        unknown: hill.unknown,
        small: hill.small,
        order: options.order,
        parameters: oscillator.parameters.clone(),
        time_scale,
        frequency: hill.frequency,
        damping,
        stiffness,
        highest_harmonic: hill.highest_harmonic,
        curves,
    })
}

/// `c(t)` and the coefficient of `x`.
fn linear_coefficients(oscillator: &Oscillator) -> Result<[Expr; 2], HillError> {
    let [x, v] = [oscillator.coordinate, oscillator.velocity()];
    let force = oscillator.force.expand()?;
    let damping = force.differentiate(v)?.expand()?;
    let stiffness = force.differentiate(x)?.expand()?;
    let bent = |expression: &Expr| expression.contains(x) || expression.contains(v);
    if bent(&damping) || bent(&stiffness) {
        let bent_term = |term: &&Expr| {
            [x, v].iter().any(|name| term.differentiate(*name).is_ok_and(|slope| bent(&slope)))
        };
        let term = force.terms().iter().find(bent_term).unwrap_or(&force);
        return Err(HillError::NotLinear(as_typed(oscillator, &|typed| bent_term(&typed), term)));
    }
    let free = |term: &Expr| !term.contains(x) && !term.contains(v);
    if let Some(term) = force.terms().iter().find(|term| free(term) && !term.is_zero()) {
        let acceleration = v.derivative();
        let drives =
            |typed: &Expr| free(typed) && !typed.contains(acceleration) && !typed.is_zero();
        return Err(HillError::Drive(as_typed(oscillator, &drives, term)));
    }
    Ok([damping, stiffness])
}

/// The symbol W of the frequency of the waves if it occurs in the coefficients as well, as in
/// `amp*W^2*cos(W*t)`, and the curves are to be solved for it: because it was requested, or because
/// it is the only candidate.
fn time_scale(coefficients: &[Expr; 2], asked: Option<&str>) -> Option<Symbol> {
    let frequency = periodic::frequency(coefficients).ok()??;
    let [(name, 1)] = frequency.unit.factors() else {
        return None;
    };
    let mut series = Vec::new();
    for coefficient in coefficients {
        series.push(periodic::series(coefficient, &frequency).ok()?);
    }
    let stands = |polynomial: &Polynomial| {
        polynomial.terms().any(|(monomial, _)| monomial.exponent(*name) != 0)
    };
    if !series.iter().flat_map(FourierSeries::numerators).any(stands) {
        return None;
    }
    let is_wanted = match asked {
        Some(asked) => asked == name.name(),
        None => stiffness_letters(&series[1].constant_term()).next().is_none(),
    };
    is_wanted.then_some(*name)
}

/// The coefficients in the time `tau = W*t`, written `t` again: `c(t/W)/W` and `k(t/W)/W^2`.
fn in_scaled_time([damping, stiffness]: &[Expr; 2], name: Symbol) -> Result<[Expr; 2], HillError> {
    let unit = Expr::from(name);
    let time = Expr::divide(&Expr::symbol("t"), &unit)?;
    let scaled = |coefficient: &Expr, power: i64| -> Result<Expr, ExprError> {
        let in_time = coefficient.substitute("t".into(), &time)?;
        Expr::divide(&in_time, &unit.integer_power(power)?)?.expand()
    };
    Ok([scaled(damping, 1)?, scaled(stiffness, 2)?])
}

/// The symbols that are a term of the mean stiffness by themselves.
fn stiffness_letters(mean: &Polynomial) -> impl Iterator<Item = Symbol> {
    mean.terms().filter_map(|(monomial, _)| match monomial.factors() {
        [(name, 1)] => Some(*name),
        _ => None,
    })
}

/// The first typed term for which `is_meant` holds, else the term as it was understood.
fn as_typed(oscillator: &Oscillator, is_meant: &dyn Fn(&Expr) -> bool, term: &Expr) -> String {
    match oscillator.typed.values().position(|value| is_meant(&value)) {
        Some(number) => oscillator.typed.quote(&[number]),
        None => term.to_string(),
    }
}

impl Hill {
    fn new(
        oscillator: &Oscillator,
        [damping, stiffness]: [&Expr; 2],
        time_scale: Option<Symbol>,
        options: &HillOptions,
    ) -> Result<Self, HillError> {
        let not_periodic = |part: Expr| {
            let meant = |typed: &Expr| typed.unique_nodes().any(|node| *node == part);
            let whole = as_typed(oscillator, &meant, &part);
            HillError::NotPeriodic(whole)
        };
        let time = Symbol::new("t");
        if !damping.contains(time) && !stiffness.contains(time) {
            return Err(HillError::Constant);
        }
        let frequency = periodic::frequency([damping, stiffness]).map_err(not_periodic)?;
        let frequency = frequency.ok_or_else(|| {
            let mut terms = stiffness.terms().iter().chain(damping.terms());
            let moving = terms.find(|term| term.contains(time));
            not_periodic(moving.unwrap_or(stiffness).clone())
        })?;
        let damping = periodic::series(damping, &frequency).map_err(not_periodic)?;
        let stiffness = periodic::series(stiffness, &frequency).map_err(not_periodic)?;
        if periodic::is_constant(&damping) && periodic::is_constant(&stiffness) {
            return Err(HillError::Constant);
        }
        let (frequency, [damping, stiffness]) =
            periodic::in_lowest_terms(frequency, [damping, stiffness]);
        let mean = stiffness.constant_term();
        let asked = time_scale.map(Symbol::name).or(options.solve_for.as_deref());
        let unknown =
            unknown(&mean, [&damping, &stiffness], &frequency, asked).map_err(|error| {
                match time_scale {
                    Some(name) => {
                        HillError::InSeveralTerms(name, terms_with(name, [&damping, &stiffness]))
                    }
                    None => error,
                }
            })?;
        let small = small(oscillator, [&damping, &stiffness], &frequency, options)?;
        let degree = |monomial: &Monomial| {
            small.iter().map(|name| i64::from(monomial.exponent(*name))).sum::<i64>()
        };
        let (mut constant, mut factor) = (Polynomial::zero(), Polynomial::zero());
        for (monomial, number) in mean.terms() {
            match unknown {
                Unknown::Stiffness { name, .. }
                    if monomial.exponent(name) != 0 && degree(monomial) == 0 =>
                {
                    factor = Polynomial::term(monomial.without(name), number.clone());
                }
                _ if degree(monomial) == 0 => constant.add_term(monomial.clone(), number.clone()),
                _ => {}
            }
        }
        let positive = constant.single_term().is_some_and(|(_, number)| *number > Rational::zero());
        if matches!(unknown, Unknown::Frequency(_)) && !positive {
            return Err(HillError::Stiffness(constant.to_string()));
        }
        let kept = unknown.given().product(&factor);
        let kept = FourierSeries::constant(POLYNOMIALS, constant.clone())
            .sum(&FourierSeries::constant(POLYNOMIALS, kept));
        let varying = stiffness.difference(&kept);
        let names: Vec<&str> = small.iter().map(|name| name.name()).collect();
        let terms = || varying.numerators().chain(damping.numerators()).flat_map(Polynomial::terms);
        let enters_otherwise =
            |monomial: &Monomial| small.iter().any(|name| monomial.exponent(*name) < 0);
        if let Some((monomial, number)) =
            terms().find(|term| degree(term.0) < 1 || enters_otherwise(term.0))
        {
            let term = Polynomial::term(monomial.clone(), number.clone());
            return Err(HillError::NotSmall(term.to_string(), names.join(", ")));
        }
        let highest = terms().map(|term| degree(term.0)).max().unwrap_or(0);
        let part = |series: &FourierSeries<Polynomials>, wanted: i64| {
            series.map(POLYNOMIALS, |polynomial, _| {
                let mut part = Polynomial::zero();
                for (monomial, number) in polynomial.terms().filter(|term| degree(term.0) == wanted)
                {
                    part.add_term(monomial.clone(), number.clone());
                }
                part
            })
        };
        let highest = highest.min(i64::from(options.order));
        Ok(Self {
            unknown,
            factor,
            constant,
            graded: (1..=highest)
                .map(|degree| [part(&varying, degree), part(&damping, degree)])
                .collect(),
            small,
            frequency,
            highest_harmonic: damping.highest_harmonic().max(stiffness.highest_harmonic()),
        })
    }
}

/// Chooses the unknown of the curves: a symbol that occurs only in the mean stiffness, or the
/// frequency.
fn unknown(
    mean: &Polynomial,
    coefficients: [&FourierSeries<Polynomials>; 2],
    frequency: &Frequency,
    asked: Option<&str>,
) -> Result<Unknown, HillError> {
    let mut seen = std::collections::BTreeMap::<Symbol, usize>::new();
    let terms =
        coefficients.iter().flat_map(|series| series.numerators()).flat_map(Polynomial::terms);
    for (monomial, _) in terms {
        for (name, _) in monomial.factors() {
            *seen.entry(*name).or_default() += 1;
        }
    }
    let alone = |name: &Symbol| {
        seen.get(name) == Some(&1) && frequency.unit.exponent(*name) == 0 && name.name() != "pi"
    };
    let candidates: Vec<Symbol> = stiffness_letters(mean).filter(alone).collect();
    let driving = match frequency.unit.factors() {
        [(name, 1)] if !seen.contains_key(name) => Some(*name),
        _ => None,
    };
    if let Some(asked) = asked {
        let name = Symbol::new(asked);
        let power =
            mean.terms().map(|(monomial, _)| monomial.exponent(name)).find(|power| *power != 0);
        return match (power.filter(|_| alone(&name)), driving) {
            (Some(power), _) => Ok(Unknown::Stiffness { name, power }),
            (None, Some(frequency)) if frequency == name => Ok(Unknown::Frequency(name)),
            _ => Err(HillError::NotAnUnknown(asked.to_owned())),
        };
    }
    let delta = Symbol::new("delta");
    match (candidates.as_slice(), driving) {
        ([only], _) => Ok(Unknown::Stiffness { name: *only, power: 1 }),
        (several, _) if several.contains(&delta) => {
            Ok(Unknown::Stiffness { name: delta, power: 1 })
        }
        ([], Some(frequency)) => Ok(Unknown::Frequency(frequency)),
        ([], None) => Err(HillError::NoUnknown),
        (several, _) => Err(HillError::SeveralUnknowns(listed(several))),
    }
}

/// The terms of the coefficients that contain a symbol: `c/W`, `g/(l*W^2)`.
fn terms_with(name: Symbol, coefficients: [&FourierSeries<Polynomials>; 2]) -> String {
    let terms =
        coefficients.into_iter().flat_map(FourierSeries::numerators).flat_map(Polynomial::terms);
    let mut terms: Vec<String> = terms
        .filter(|(monomial, _)| monomial.exponent(name) != 0)
        .map(|(monomial, number)| {
            format!("`{}`", Expr::from(&Polynomial::term(monomial.clone(), number.clone())))
        })
        .collect();
    terms.dedup();
    terms.join(", ")
}

fn listed(names: &[Symbol]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

/// The small parameters: those that were named, or else `eps` and every symbol that alone
/// multiplies a harmonic or the velocity.
fn small(
    oscillator: &Oscillator,
    [damping, stiffness]: [&FourierSeries<Polynomials>; 2],
    frequency: &Frequency,
    options: &HillOptions,
) -> Result<Vec<Symbol>, HillError> {
    if !options.small.is_empty() {
        let names = options.small.iter().map(|name| Symbol::new(name));
        let mut known = Vec::new();
        for name in names {
            if !oscillator.parameters.contains(&name) {
                return Err(HillError::UnknownSmall(name.to_string()));
            }
            if !known.contains(&name) {
                known.push(name);
            }
        }
        return Ok(known);
    }
    let waves = stiffness.harmonics().into_iter().filter(|(harmonic, ..)| *harmonic > 0);
    let before_waves = waves.flat_map(|(_, cosine, sine)| [cosine, sine]);
    let before_velocity =
        damping.harmonics().into_iter().flat_map(|(_, cosine, sine)| [cosine, sine]);
    let coefficients: Vec<Polynomial> = before_waves.chain(before_velocity).collect();
    let letters = |monomial: &Monomial| -> Vec<Symbol> {
        let names = monomial.factors().iter().map(|factor| factor.0);
        names.filter(|name| name.name() != "pi" && frequency.unit.exponent(*name) == 0).collect()
    };
    let terms: Vec<(Vec<Symbol>, String)> = coefficients
        .iter()
        .flat_map(Polynomial::terms)
        .map(|(monomial, number)| {
            let term = Polynomial::term(monomial.clone(), number.clone());
            (letters(monomial), term.to_string())
        })
        .collect();
    if let Some((_, number)) = terms.iter().find(|(letters, _)| letters.is_empty()) {
        let whose = |typed: &Expr| {
            typed.contains(Symbol::new("t")) || typed.contains(oscillator.velocity())
        };
        let term = as_typed(oscillator, &whose, &Expr::symbol("t"));
        return Err(HillError::NumberIsSmall(match term.as_str() {
            "t" => number.clone(),
            _ => term,
        }));
    }
    let mut small = BTreeSet::new();
    let eps = Symbol::new("eps");
    if terms.iter().any(|(letters, _)| letters.contains(&eps)) {
        small.insert(eps);
    }
    for (letters, _) in &terms {
        if let [only] = letters.as_slice() {
            small.insert(*only);
        }
    }
    // If a coefficient is `amp/l` and the mean stiffness is `g/l`, only `amp` can vanish by itself.
    let mean = stiffness.constant_term();
    let in_mean = |name: &Symbol| mean.terms().any(|(monomial, _)| monomial.exponent(*name) != 0);
    for (letters, _) in &terms {
        if !letters.iter().any(|name| small.contains(name)) {
            let mut of_waves_alone = letters.iter().filter(|name| !in_mean(name));
            match (of_waves_alone.next(), of_waves_alone.next()) {
                (Some(only), None) => small.insert(*only),
                _ => return Err(HillError::SeveralSmall(listed(letters))),
            };
        }
    }
    Ok(small.into_iter().collect())
}

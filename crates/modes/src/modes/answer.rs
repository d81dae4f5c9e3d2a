//! The nonlinear normal modes of a system: frequency laws, motions, modal lines.

use std::collections::BTreeMap;

use num_traits::Zero;

use super::expansion::{Expansion, ExpansionStep, OverRing, Question};
use super::free_system::ForceTerm;
use super::harmonic_balance::{ModeBalance, balance, mode_of_balance};
use super::inverse::HarmonicInverses;
use super::linear::{DIGITS, LinearMode, LinearModes, NearResonance};
use super::modal_line::modal_lines;
use super::{FreeSystem, ModeError, steps};
use crate::decimal::rounded_fraction;
use crate::derivation::DerivationLine;
use crate::exact::polynomial::Monomial;
use crate::exact::rational::to_f64;
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials, Rational, Rationals};
use crate::expr::Expr;
use crate::interrupt::Supervision;
use crate::method::approximant;
use crate::series::FourierSeries;
use crate::solution::{AmplitudeConvention, Definition, Degrees, Method, Sum, definitions_behind};
use crate::symbol::Symbol;

/// The order without a choice.
const USUAL_ORDER: u32 = 4;

/// The highest order.
const HIGHEST_ORDER: u32 = 200;

/// Size below which a coefficient of rounded numbers is what is left of terms that cancel.
const NOISE: f64 = 1e-50;

/// Number of digits of rounded coefficients.
const KEPT_DIGITS: usize = 15;

/// The choices of a derivation.
#[derive(Clone, Copy, Debug)]
pub struct ModeOptions {
    /// The mode, 1 for the slowest; all of them without it.
    pub mode: Option<usize>,
    /// The highest power of the amplitude in omega^2; 4 without it, and without `pade`.
    pub order: Option<u32>,
    /// The degrees in a^2 of numerator and denominator of an approximant of omega^2, in place of its
    /// series.
    pub pade: Option<(u32, u32)>,
    /// The number of harmonics to balance, in place of a series; the amplitude is the start of the first
    /// coordinate then, whatever `amplitude` says.
    pub harmonics: Option<u32>,
    /// The definition of the amplitude.
    pub amplitude: AmplitudeConvention,
    /// Whether the derivation is kept, order by order.
    pub steps: bool,
    /// Interrupt and progress.
    pub supervision: Supervision,
}

impl Default for ModeOptions {
    fn default() -> Self {
        Self {
            mode: None,
            order: None,
            pade: None,
            harmonics: None,
            amplitude: AmplitudeConvention::FirstHarmonic,
            steps: false,
            supervision: Supervision::default(),
        }
    }
}

/// The nonlinear normal modes of a system.
#[derive(Clone, Debug)]
pub struct NormalModes {
    /// The system.
    pub system: FreeSystem,
    /// The modes that were asked for, the slowest first, or the reason why one has no formula.
    pub modes: Vec<Result<NonlinearMode, ModeError>>,
    /// The number of all modes.
    pub count: usize,
    /// The highest power of the amplitude in omega^2 that was asked for, or the number of harmonics.
    pub order: u32,
    /// The definition of the amplitude.
    pub amplitude: AmplitudeConvention,
}

impl NormalModes {
    /// The method by which the modes were derived.
    pub fn method(&self) -> Method {
        let modes = || self.modes.iter().flatten();
        match modes().find(|mode| mode.approximant.is_some()).or_else(|| modes().next()) {
            Some(mode) if mode.balance.is_some() => Method::HarmonicBalance,
            Some(mode) if mode.approximant.is_some() => Method::Pade,
            _ => Method::LindstedtPoincare,
        }
    }
}

/// The linear mode at which a nonlinear one begins.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearShape {
    /// The square of its frequency.
    pub square: Polynomial,
    /// Its shape v; the first coordinate that moves has 1.
    pub shape: Vec<Polynomial>,
    /// `u^T M/(u^T M v)`, where u is the shape under the transposed matrices: the sum of the
    /// coordinates, each with its factor, of which the amplitude is that of the first harmonic. With
    /// symmetric matrices u is v.
    pub modal: Vec<Polynomial>,
}

impl LinearShape {
    fn new(
        system: &FreeSystem,
        mode: &LinearMode,
        round: &dyn Fn(&Polynomial) -> Polynomial,
    ) -> Self {
        let rounded_all = |entries: &[Polynomial]| entries.iter().map(round).collect();
        Self {
            square: round(&mode.square),
            shape: rounded_all(&mode.shape),
            modal: rounded_all(&modal_coordinate(&system.mass, mode)),
        }
    }

    /// The first coordinate that moves.
    pub(super) fn along(&self) -> usize {
        self.shape.iter().position(|entry| !entry.is_zero()).unwrap_or(0)
    }
}

/// A quotient of polynomials that agrees with a series.
#[derive(Clone, Debug, PartialEq)]
pub struct Approximant {
    /// The degrees of numerator and denominator in a^2.
    pub degrees: Degrees,
    /// The numerator.
    pub above: Polynomial,
    /// The denominator.
    pub below: Polynomial,
    /// omega^2, the quotient of both.
    pub value: Expr,
}

/// A nonlinear normal mode in formulas.
///
/// Polynomials are in the parameters of the equations, the amplitude symbol and the symbols of
/// `definitions`.
#[derive(Clone, Debug)]
pub struct NonlinearMode {
    /// Its number, 1 for the slowest.
    pub number: usize,
    /// The highest power of the amplitude in omega^2, inclusive, or the number of harmonics.
    pub order: u32,
    /// The definition of the amplitude.
    pub amplitude: AmplitudeConvention,
    /// The linear mode.
    pub linear: LinearShape,
    /// omega^2 in powers of the amplitude; in omega itself where a balance gives it.
    pub frequency_squared: Polynomial,
    /// A quotient of polynomials in place of that series; `None` if it was not asked for.
    pub approximant: Option<Approximant>,
    /// The balance of harmonics that determines omega and the coefficients of the motion; `None` for
    /// a series.
    pub balance: Option<ModeBalance>,
    /// The motion of each coordinate, a series of cosines of `theta = omega t`.
    pub motion: Vec<FourierSeries<Polynomials>>,
    /// The coordinate in which the modal lines are written: the first that moves in the linear mode.
    pub along: usize,
    /// Each coordinate as a function of that one and of the amplitude.
    pub lines: Vec<Polynomial>,
    /// The other modes whose frequency is near a multiple that occurs in the motion, where the roots are
    /// numbers.
    pub near: Vec<NearResonance>,
    /// Symbols that the formulas introduce; each may use those before it.
    pub definitions: Vec<Definition>,
    /// Whether the coefficients are rounded to fifteen digits, because the linear frequency is no
    /// closed root.
    pub rounded: bool,
    /// The derivation order by order; empty if it was not asked for.
    pub derivation: Vec<DerivationLine>,
}

impl NonlinearMode {
    /// A polynomial with its terms by rising powers of the amplitude.
    pub fn ordered(&self, polynomial: &Polynomial) -> Sum {
        let amplitude = self.amplitude.symbol();
        Sum::new(polynomial, self.rounded, |monomial| monomial.exponent(amplitude))
    }

    /// The modes whose frequency is near a multiple that occurs in the motion, where every letter of the
    /// equations has a value; none where the numbers have no modes.
    pub fn near_at(
        &self,
        system: &FreeSystem,
        values: &BTreeMap<Symbol, Expr>,
    ) -> Vec<NearResonance> {
        if self.balance.is_some() {
            return vec![];
        }
        let Ok(numbers) = system.with_values(values) else { return vec![] };
        match LinearModes::new(&numbers.mass, &numbers.stiffness, numbers.names()) {
            Ok(linear) if linear.count() >= self.number => self.occurring(&linear),
            _ => vec![],
        }
    }

    /// The near resonances of linear modes whose ratio occurs in the motion.
    fn occurring(&self, linear: &LinearModes) -> Vec<NearResonance> {
        let occurs = |near: &NearResonance| {
            let mut harmonics = self.motion.iter().map(|series| series.cosine(near.ratio));
            harmonics.any(|harmonic| !harmonic.is_zero())
        };
        let near = linear.near_resonances(self.number - 1, self.order as usize + 1);
        near.into_iter().filter(occurs).collect()
    }

    /// The law in one line.
    pub fn formula(&self) -> String {
        if let Some(balance) = &self.balance {
            return format!("omega by the balance of harmonics {}", balance.harmonics_in_words());
        }
        match &self.approximant {
            Some(own) if self.rounded => {
                let [above, below] = [&own.above, &own.below].map(|part| self.ordered(part));
                format!("omega^2 = ({above})/({below})")
            }
            Some(own) => format!("omega^2 = {}", own.value),
            None => format!("omega^2 = {}", self.ordered(&self.frequency_squared)),
        }
    }
}

/// Derives nonlinear normal modes by Lindstedt and Poincare.
///
/// # Errors
/// [`ModeError`] if there are no modes in formulas at all, or no mode of the number that was asked
/// for; what concerns one mode is in [`NormalModes::modes`].
///
/// ```
/// # use lindstedt_modes as lindstedt;
/// use lindstedt::modes::{FreeSystem, ModeOptions, derive};
///
/// let pair = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0")?;
/// let modes = derive(&pair, &ModeOptions::default())?.modes;
/// let laws: Vec<String> = modes.iter().flatten().map(|mode| mode.formula()).collect();
/// assert_eq!(laws, [
///     "omega^2 = 1 + 3*a^2/16 - 101*a^4/2048",
///     "omega^2 = 3 + 3*a^2/16 + 1429*a^4/26624",
/// ]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn derive(system: &FreeSystem, options: &ModeOptions) -> Result<NormalModes, ModeError> {
    let of_approximant =
        options.pade.map(|(above, below)| above.saturating_add(below).saturating_mul(2));
    let order = of_approximant.or(options.order).unwrap_or(USUAL_ORDER);
    if order > HIGHEST_ORDER && options.harmonics.is_none() {
        return Err(ModeError::Order(order, HIGHEST_ORDER));
    }
    let mut system = system.clone();
    let linear = LinearModes::new(&system.mass, &system.stiffness, system.names())?;
    let count = linear.count();
    let numbers = match options.mode {
        None => 1..=count,
        Some(number) if (1..=count).contains(&number) => number..=number,
        Some(number) => return Err(ModeError::NoSuchMode { number, count }),
    };
    let modes = match options.harmonics {
        Some(harmonics) => {
            let (balance, motion) = balance(&mut system, harmonics)?;
            let of = |number| {
                let mode = linear.mode(number - 1)?;
                let shown = kept_digits(linear.is_rounded(number - 1));
                let shape = LinearShape::new(&system, &mode, &shown);
                let mut found = mode_of_balance(number, shape, balance.clone(), motion.clone());
                let known = system.constants.iter().chain(linear.definitions()).cloned();
                found.definitions = used(&found, &known.collect::<Vec<_>>());
                found.rounded = linear.is_rounded(number - 1);
                Ok(found)
            };
            numbers.map(of).collect()
        }
        None => {
            let force = system.force_terms(order + 1)?;
            let of = |number| {
                let mode = linear.mode(number - 1)?;
                one_mode(&system, &force, &linear, number, &mode, order, options)
            };
            numbers.map(of).collect()
        }
    };
    let (order, amplitude) = match options.harmonics {
        Some(harmonics) => (harmonics, AmplitudeConvention::Initial),
        None => (order, options.amplitude),
    };
    Ok(NormalModes { system, modes, count, order, amplitude })
}

fn one_mode(
    system: &FreeSystem,
    force: &[Vec<ForceTerm>],
    linear: &LinearModes,
    number: usize,
    mode: &LinearMode,
    order: u32,
    options: &ModeOptions,
) -> Result<NonlinearMode, ModeError> {
    let known = system.constants.iter().chain(linear.definitions()).cloned();
    let known: Vec<Definition> = known.collect();
    let names = known.iter().map(|definition| definition.symbol);
    let taken = system.names().into_iter().chain(names).collect();
    let mut inverses = HarmonicInverses::new(linear, number - 1, &mode.square, taken);
    let basis = linear.basis(number - 1, mode, &system.mass);
    let rounded = linear.is_rounded(number - 1);
    let question = Question {
        number,
        square: &mode.square,
        basis: &basis,
        force,
        order: order as usize,
        amplitude: options.amplitude,
        steps: options.steps,
        supervision: options.supervision,
    };
    let round = |number: &Rational| match rounded {
        true => rounded_fraction(number, DIGITS),
        false => number.clone(),
    };
    let has_letters = force.iter().flatten().any(|term| term.coefficient.as_number().is_none());
    let mut inverse_of = |harmonic| inverses.of(harmonic);
    let expansion = match has_letters || matches!(linear, LinearModes::Two(_)) {
        true => OverRing {
            question: &question,
            ring: POLYNOMIALS,
            element: &Polynomial::clone,
            tidy: &|element| element.map(round),
        }
        .expand(&mut inverse_of)?,
        false => in_polynomials(
            OverRing {
                question: &question,
                ring: Rationals,
                element: &|number| number.as_number().unwrap_or_else(Rational::zero),
                tidy: &round,
            }
            .expand(&mut inverse_of)?,
        ),
    };
    let names = system.names().into_iter();
    let defined = known.iter().chain(&inverses.definitions).map(|definition| definition.symbol);
    let taken = names.chain(defined).collect();
    let derivation =
        steps::derivation(system, &basis, &expansion, options.amplitude.symbol(), taken);
    let definitions: Vec<Definition> =
        known.into_iter().chain(std::mem::take(&mut inverses.definitions)).collect();
    let mut found = in_amplitude(system, expansion, number, mode, rounded, options);
    found.near = found.occurring(linear);
    found.derivation = match rounded {
        true => derivation.iter().map(|line| line.with_numbers(&to_shown_digits)).collect(),
        false => derivation,
    };
    found.definitions = used(&found, &definitions);
    if let Some((above, below)) = options.pade.filter(|_| found.order == order) {
        let degrees = Degrees::Quotient(above, below);
        let series = found.frequency_squared.clone();
        let refused = |reason| ModeError::Approximant { number, degrees, reason };
        let parts = approximant(series, options.amplitude.symbol(), (above, below));
        let [above, below] = parts.map_err(refused)?;
        let value = Expr::divide(&Expr::from(&above), &Expr::from(&below));
        let value = value.map_err(|_| refused("its denominator is zero"))?;
        found.approximant = Some(Approximant { degrees, above, below, value });
    }
    Ok(found)
}

/// A rounded number of a derivation with the digits that are shown.
fn to_shown_digits(number: &Rational) -> Rational {
    const SHOWN_DIGITS: usize = 9;
    match to_f64(number).abs() < NOISE {
        true => Rational::zero(),
        false => rounded_fraction(number, SHOWN_DIGITS),
    }
}

/// The orders with polynomials as coefficients.
fn in_polynomials(expansion: Expansion<Rationals>) -> Expansion<Polynomials> {
    let constant = Polynomial::constant;
    let all = |of: &[FourierSeries<Rationals>]| -> Vec<FourierSeries<Polynomials>> {
        of.iter().map(|series| series.map(POLYNOMIALS, |c, _| constant(c.clone()))).collect()
    };
    let step = |step: &ExpansionStep<Rationals>| ExpansionStep {
        right_sides: all(&step.right_sides),
        unknowns: all(&step.unknowns),
    };
    Expansion {
        frequency_squared: expansion.frequency_squared.into_iter().map(constant).collect(),
        motion: expansion.motion.iter().map(|order| all(order)).collect(),
        steps: expansion.steps.iter().map(step).collect(),
    }
}

/// The digits of a polynomial that are kept: of rounded numbers fifteen.
fn kept_digits(rounded: bool) -> impl Fn(&Polynomial) -> Polynomial {
    move |polynomial| match rounded {
        true => polynomial.map(|number| match to_f64(number).abs() < NOISE {
            true => Rational::zero(),
            false => rounded_fraction(number, KEPT_DIGITS),
        }),
        false => polynomial.clone(),
    }
}

/// The sums over the orders, each with its power of the amplitude.
fn in_amplitude(
    system: &FreeSystem,
    expansion: Expansion<Polynomials>,
    number: usize,
    mode: &LinearMode,
    rounded: bool,
    options: &ModeOptions,
) -> NonlinearMode {
    let amplitude = options.amplitude.symbol();
    let coordinates = &system.equations.coordinates;
    let power = |exponent: usize| {
        Monomial::power_of(amplitude, i32::try_from(exponent).unwrap_or(i32::MAX))
    };
    let round = kept_digits(rounded);
    let reached = expansion.frequency_squared.len() - 1;
    let mut frequency_squared = Polynomial::zero();
    for (exponent, coefficient) in expansion.frequency_squared.iter().enumerate() {
        frequency_squared.accumulate(&coefficient.times_monomial(&power(exponent)));
    }
    let motion = (0..coordinates.len()).map(|coordinate| {
        let orders = expansion.motion.iter().enumerate();
        orders.fold(FourierSeries::zero(POLYNOMIALS), |sum, (index, order)| {
            let scaled = order[coordinate]
                .map(POLYNOMIALS, |coefficient, _| coefficient.times_monomial(&power(index + 1)));
            sum.sum(&scaled)
        })
    });
    let linear = LinearShape::new(system, mode, &round);
    let along = linear.along();
    let lines = modal_lines(&expansion.motion, along, coordinates[along], amplitude);
    NonlinearMode {
        number,
        order: u32::try_from(reached).unwrap_or(u32::MAX),
        amplitude: options.amplitude,
        linear,
        frequency_squared: round(&frequency_squared),
        approximant: None,
        balance: None,
        motion: motion
            .map(|series| series.map(POLYNOMIALS, |coefficient, _| round(coefficient)))
            .collect(),
        along,
        lines: lines.iter().map(&round).collect(),
        near: vec![],
        definitions: vec![],
        rounded,
        derivation: vec![],
    }
}

/// `u^T M/(u^T M v)`. An entry that is a number times `u^T M v` is that number, also where the sum
/// `u^T M v` has a name, by which it cannot be seen.
fn modal_coordinate(mass: &[Vec<Polynomial>], mode: &LinearMode) -> Vec<Polynomial> {
    let row: Vec<Polynomial> = (0..mass.len())
        .map(|column| {
            let products = mode.left.iter().zip(mass).map(|(left, row)| left.product(&row[column]));
            products.fold(Polynomial::zero(), |sum, product| sum + product)
        })
        .collect();
    let products = row.iter().zip(&mode.shape).map(|(entry, shape)| entry.product(shape));
    let modal_mass = products.fold(Polynomial::zero(), |sum, product| sum + product);
    let over_mass = |entry: &Polynomial| match multiple(entry, &modal_mass) {
        Some(number) => Polynomial::constant(number),
        None => entry.product(&mode.inverse_mass),
    };
    row.iter().map(over_mass).collect()
}

/// The number by which a polynomial is a multiple of another; `None` if it is none.
fn multiple(polynomial: &Polynomial, other: &Polynomial) -> Option<Rational> {
    let (monomial, coefficient) = other.terms().next()?;
    let number = polynomial.coefficient(monomial) / coefficient;
    (other.map(|own| own * &number) == *polynomial).then_some(number)
}

/// The definitions that occur in a mode, or in others that do.
fn used(mode: &NonlinearMode, definitions: &[Definition]) -> Vec<Definition> {
    let linear = &mode.linear;
    let polynomials = std::iter::once(&mode.frequency_squared)
        .chain(std::iter::once(&linear.square))
        .chain(&linear.shape)
        .chain(&linear.modal)
        .chain(&mode.lines)
        .chain(mode.motion.iter().flat_map(FourierSeries::numerators));
    let of_derivation = mode.derivation.iter().flat_map(DerivationLine::symbols);
    let names = polynomials.flat_map(Polynomial::symbols).chain(of_derivation).collect();
    definitions_behind(definitions, names).into_iter().cloned().collect()
}

//! The methods: each takes an [`Oscillator`] and options, and gives a [`Solution`] or a
//! [`Refusal`].
//!
//! In comes the equation with its [`Options`]; [`solve`] moves the origin to its equilibrium and
//! calls the method of the table. Out goes a law and a motion with exact coefficients, the notes on
//! where they hold and the derivation; or the [`Reason`] why not, with the term in the way and
//! advice on what to try. At numbers, [`numbers`] gives the frequency and the motion of any answer.
//!
//! One file per method, each opening with its reference and equations. To add one: write its file
//! with a function `solve(&Oscillator, &Options) -> Result<Solution, Refusal>`, give it a name in
//! [`Method`] and a row in [`table::METHODS`].

pub(crate) mod amplitude_frequency;
pub mod averaging;
pub(crate) mod balance;
mod base_motion;
mod convergence_control;
mod default_method;
mod drive;
mod driven_answer;
pub(crate) mod energy_balance;
pub(crate) mod exact;
mod exact_motion;
pub(crate) mod expansion;
pub(crate) mod first_order;
mod forced_waves;
pub(crate) mod frequency_formula;
mod frequency_response;
pub(crate) mod hamiltonian;
pub(crate) mod harmonic_balance;
pub(crate) mod hermite_pade;
pub mod homotopy_analysis;
pub(crate) mod homotopy_perturbation;
pub mod inertia;
pub(crate) mod iteration_perturbation;
pub(crate) mod joint_expansion;
pub(crate) mod limit_cycle;
pub(crate) mod lindstedt_poincare;
mod linear;
pub(crate) mod max_min;
pub mod motion;
pub mod multiple_scales;
pub mod numbers;
pub(crate) mod one_term;
pub(crate) mod pade;
pub(crate) mod parameter_expansion;
pub mod power_series;
mod quotation;
mod refusal;
mod resonance;
pub mod secular;
pub mod table;
pub(crate) mod transient;
pub(crate) mod variational_iteration;

pub use default_method::default_method;
pub use drive::{HarmonicExcitation, Quadrature};
pub use harmonic_balance::{MOST_HARMONICS, harmonics};
pub use pade::approximant;
pub use refusal::{Reason, Refusal, Refuser};

pub use resonance::with_resonance_at;

pub use crate::conservative::{CentredForce, cosine_coefficient, is_odd, is_smooth, potential};
pub use crate::equilibrium::with_numbers_where_needed;

use std::collections::BTreeMap;

use num_traits::Zero;
use table::{Choice, MethodEntry};

use crate::equilibrium::{Centred, centred, stable_elsewhere};
use crate::exact::{POLYNOMIALS, Polynomial};
use crate::expr::{Expr, NAMES_OF_ANSWERS};
use crate::interrupt::Supervision;
use crate::oscillator::corner::near_rest;
use crate::oscillator::{Oscillator, OscillatorError, SmallParameter};
use crate::series::FourierSeries;
use crate::solution::{AmplitudeConvention, Degrees, Method, Note, Solution, note::Position};
use crate::symbol::letters::AMPLITUDE;
use crate::symbol::{Symbol, fresh};

/// The highest order any method accepts.
pub const HIGHEST_ORDER: u32 = 400;

/// The highest order of the [frequency alone](Options::frequency_alone), whose coefficients are
/// fewer.
pub const HIGHEST_ORDER_OF_FREQUENCY: u32 = 2000;

/// The options of a derivation; `None` leaves the choice to the method.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// The method.
    pub method: Option<Method>,
    /// Highest power of the small parameter, inclusive.
    pub order: Option<u32>,
    /// The meaning of the amplitude.
    pub amplitude: Option<AmplitudeConvention>,
    /// The name of the small parameter; `A` or `a` for the amplitude.
    pub small: Option<String>,
    /// Degree of the Taylor polynomial by which homotopy methods replace the force.
    pub taylor: Option<u32>,
    /// The degrees of an approximant.
    pub degrees: Option<Degrees>,
    /// The convergence-control parameter of homotopy analysis; a symbol that numbers are chosen for
    /// where it is not given.
    pub hbar: Option<Expr>,
    /// Number of the limit cycle of a self-excited equation, counted from one by amplitude; if
    /// `None`, the smallest that attracts.
    pub cycle: Option<u32>,
    /// The resonance of a driven motion, Omega : omega0, two whole numbers from 1 to 9; if `None`,
    /// the nearest one to numerical frequencies, or the primary one, 2:1 for a drive in a
    /// coefficient.
    pub resonance: Option<(u32, u32)>,
    /// The frequency without the motion, to a [higher order](HIGHEST_ORDER_OF_FREQUENCY) in less
    /// time.
    pub frequency_alone: bool,
    /// The interrupt and the progress of a long expansion, which ends, if interrupted, with the
    /// orders that there are.
    ///
    /// ```
    /// # use lindstedt_oscillator as lindstedt;
    /// use lindstedt::{Counter, Interrupt, Options, Oscillator, Progress, Supervision, solve};
    /// use std::sync::atomic::AtomicBool;
    ///
    /// // Stopped before it begins: the orders that need no long work are there.
    /// static STOP: AtomicBool = AtomicBool::new(true);
    /// static COUNTER: Counter = Counter::new();
    /// let supervision = Supervision { interrupt: Interrupt::from_flag(&STOP), progress: Progress::from_counter(&COUNTER) };
    /// let options = Options { order: Some(300), frequency_alone: true, supervision, ..Options::default() };
    /// let solution = solve(&Oscillator::parse("x'' - mu*(1 - x^2)*x' + x = 0")?, &options)?;
    /// assert!((1..300).contains(&solution.order));
    /// assert!(solution.validity.iter().any(|note| note.to_string().contains("stopped")));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub supervision: Supervision,
}

impl Options {
    /// Whether the small parameter or the order is given: by an option, or by a parameter named
    /// `eps`.
    fn say_what_is_small(&self, oscillator: &Oscillator) -> bool {
        self.small.is_some()
            || self.order.is_some()
            || oscillator.parameters.contains(&Symbol::new("eps"))
    }
}

/// Solves by the method of `options`, or by the one that suits the equation.
///
/// # Errors
/// A [`Refusal`] that names the term in the way.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::{method::{Options, solve}, Oscillator};
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options { order: Some(2), ..Options::default() })?;
/// assert_eq!(solution.law.frequency_squared().unwrap().to_string(), "1 - A^2/8");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    if let Some(name) = oscillator
        .parameters
        .iter()
        .chain([&oscillator.coordinate])
        .find(|name| NAMES_OF_ANSWERS.contains(&name.name()) && !name.is_apart())
    {
        return Err(Reason::NameOfAnswer(name.apart()).into());
    }
    let _letters = oscillator.letters().in_force();
    let solution = solve_as_asked(oscillator, options)
        .map_err(|refusal| without_linear_force(refusal, oscillator, options))?;
    let phase = oscillator.phase();
    Ok(Solution {
        derivation: solution.derivation.into_iter().map(|line| line.with_phase(phase)).collect(),
        law: solution.law.with_phase(phase),
        ..solution
    })
}

/// Adds a way forward to a refusal for want of a linear restoring force. If `x = 0` repels, it
/// names the stable equilibria. Methods that need no linear force take no damping and no drive:
/// with one of them it leads to the numerical commands.
fn without_linear_force(refusal: Refusal, oscillator: &Oscillator, options: &Options) -> Refusal {
    let Reason::Oscillator(OscillatorError::NoRestoringForce(force)) = &refusal.reason else {
        return refusal;
    };
    let asked = oscillator.about.is_some();
    // With two wells, for example, the force repels here for positive parameters and pulls back
    // elsewhere.
    if let (true, false, Some(unstable)) =
        (force.has_leading_minus(), asked, stable_elsewhere(oscillator))
    {
        return unstable.into();
    }
    if let (true, Ok(centred)) = (asked && !force.is_zero(), centred(oscillator, None))
        && centred.cross_well.is_some()
    {
        let method = options.method.unwrap_or(Method::LindstedtPoincare);
        let refusal = Reason::PushesAway.to(method).about(force);
        return quotation::as_typed(refusal, oscillator, &centred);
    }
    let Ok(parts) = oscillator.parts() else {
        return refusal;
    };
    let Some(other) = [&parts.forcing, &parts.damping].into_iter().find(|part| !part.is_zero())
    else {
        return refusal;
    };
    let otherwise = match parts.forcing.is_zero() {
        true => Method::Averaging,
        false => Method::MultipleScales,
    };
    let by_averaging = Options { method: Some(Method::Averaging), ..Options::default() };
    let mut free = oscillator.clone();
    if let Ok(force) = (&oscillator.force - &parts.forcing).expand() {
        free.force = force;
    }
    let refusal = Reason::NoLinearForce {
        force: force.clone(),
        drives: !parts.forcing.is_zero(),
        averaged: solve_as_asked(&free, &by_averaging).is_ok(),
    }
    .to(options.method.unwrap_or(otherwise))
    .about(first_term(other));
    match centred(oscillator, None) {
        Ok(centred) => quotation::as_typed(refusal, oscillator, &centred),
        Err(_) => refusal,
    }
}

fn solve_as_asked(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    let found = solve_in_its_coordinate(oscillator, options);
    match found.as_ref().is_err_and(base_motion::is_of_drive) {
        true => base_motion::solve(oscillator, options)
            .or_else(|| forced_waves::solve(oscillator, options))
            .map_or(found, Ok),
        false => found,
    }
}

/// Solves in the coordinate of the equation, without trying a relative one.
fn solve_in_its_coordinate(
    oscillator: &Oscillator,
    options: &Options,
) -> Result<Solution, Refusal> {
    let limit = match options.frequency_alone {
        true => HIGHEST_ORDER_OF_FREQUENCY,
        false => HIGHEST_ORDER,
    };
    if let Some(asked) = options.order.filter(|&order| order > limit) {
        return Err(Reason::Order { asked, limit }.into());
    }
    let may_expand = match options.method {
        None => default_method(oscillator) == Method::LindstedtPoincare,
        Some(method) => method == Method::LindstedtPoincare,
    };
    // Damping does not appear at order 0, and rules a periodic motion out all the same.
    if options.order == Some(0) && may_expand {
        let first = Options { order: Some(1), ..options.clone() };
        if let Err(refusal) = solve_by(Method::LindstedtPoincare, oscillator, &first)
            && default_method::is_of_damping(&refusal, oscillator)
        {
            return Err(refusal);
        }
    }
    match options.method {
        Some(method) => solve_by(method, oscillator, options),
        None => default_method::solve(oscillator, options),
    }
}

/// Solves by one method.
fn solve_by(
    method: Method,
    oscillator: &Oscillator,
    options: &Options,
) -> Result<Solution, Refusal> {
    let entry = MethodEntry::for_method(method);
    refuse_what_it_does_not_take(entry, options)?;
    // Every method works about x = 0: the origin is moved to the equilibrium, and the answer moved
    // back.
    let polynomial = oscillator.polynomial_degree()?.is_some();
    // The formulas of a driven motion have a symbol for an equilibrium that is not a fraction.
    let driven = oscillator.force.contains(Symbol::new("t"));
    let degree = (entry.rounded_degree)(options, polynomial).filter(|_| !(driven && polynomial));
    let centred = centred(oscillator, degree)?;
    let options = &about_a_load(&centred, options);
    let answer = match inertia::solve(entry, &centred.oscillator, options) {
        Ok(Some(solution)) => Ok(solution),
        Ok(None) => (entry.solve)(&centred.oscillator, options),
        Err(refusal) => Err(refusal),
    };
    let mut solution =
        answer.map_err(|refusal| quotation::as_typed(refusal, oscillator, &centred))?;
    // The first order of a force that is not a polynomial projects the force as it is, corners and
    // all.
    let projected = method == Method::LindstedtPoincare && solution.law.frequency().is_none();
    if entry.expands() && !projected && has_corners(&oscillator.force) {
        solution.validity.push(Note::Corners);
    }
    let mut sides = centred.sides.clone();
    if entry.expands() && !projected {
        let (_, taken) = near_rest(&centred.oscillator.force, oscillator.coordinate)
            .map_err(OscillatorError::from)?;
        sides.extend(taken.into_iter().filter(|side| !centred.sides.contains(side)));
    }
    if !sides.is_empty() {
        solution.validity.push(Note::CornerSides(sides));
    }
    if centred.endless {
        solution.validity.push(Note::EndlessPotential { coordinate: oscillator.coordinate });
    }
    if let Some(motions) = &centred.cross_well {
        // A relation has no root that comes from an unstable rest.
        solution.validity.iter_mut().for_each(Note::take_root_of_first_order);
        solution.validity.push(Note::CrossWell(motions.clone()));
    }
    if centred.position.is_zero() {
        // The question is the equation as it was typed, whatever a method made of its force.
        solution.equation = oscillator.equation();
        return Ok(solution);
    }
    if let (Some(degree), true) =
        (degree, centred.numerical && !polynomial && entry.takes(Choice::Taylor))
    {
        solution.validity.push(Note::TaylorPolynomial { degree });
    }
    move_back(&mut solution, oscillator, &centred)?;
    Ok(solution)
}

/// An option that a method has no use for is a mistake, and never ignored.
fn refuse_what_it_does_not_take(entry: &MethodEntry, options: &Options) -> Result<(), Refusal> {
    let given = [
        (Choice::Order, options.order.is_some()),
        (Choice::Degrees, options.degrees.is_some()),
        (Choice::Taylor, options.taylor.is_some()),
        (Choice::Hbar, options.hbar.is_some()),
        (Choice::Cycle, options.cycle.is_some()),
        (Choice::Resonance, options.resonance.is_some()),
        (Choice::FrequencyAlone, options.frequency_alone),
    ];
    match given.iter().find(|(choice, given)| *given && !entry.takes(*choice)) {
        Some(&(choice, _)) => Err(Reason::NoSuchChoice(choice).to(entry.method)),
        None => Ok(()),
    }
}

/// The options with the amplitude as the small parameter, if the default one would be a parameter
/// that moves the equilibrium.
fn about_a_load(centred: &Centred, options: &Options) -> Options {
    let small = centred.oscillator.small_parameter(options.small.as_deref());
    let moves = |name: Symbol| centred.position.contains(name);
    let amplitude = options.small.is_none()
        && matches!(small, Ok(SmallParameter::Parameter(name)) if moves(name));
    Options {
        small: if amplitude { Some(AMPLITUDE.to_string()) } else { options.small.clone() },
        ..options.clone()
    }
}

/// Adds the equilibrium to an answer about zero.
fn move_back(
    solution: &mut Solution,
    oscillator: &Oscillator,
    centred: &Centred,
) -> Result<(), Refusal> {
    let x = oscillator.coordinate;
    let written = centred.written.to_polynomial(&mut |_| None)?;
    // An equilibrium that is not a polynomial has a symbol.
    let position = written.unwrap_or_else(Polynomial::zero);
    // A motion that is only evaluated numerically has no displacement to move.
    if !solution.displacement.is_zero() {
        let position = FourierSeries::constant(POLYNOMIALS, position);
        solution.displacement = solution.displacement.sum(&position);
        let motion = solution.modulation.as_mut().and_then(|slow| slow.motion.as_mut());
        if let Some(motion) = motion {
            *motion = motion.sum(&position);
        }
    }
    if let Some(response) = &mut solution.response {
        response.motion = &response.motion + &centred.written;
    }
    if let Some(motion) = &mut solution.closed_motion {
        *motion = &*motion + &centred.written;
    }
    solution.equation = oscillator.equation();
    if centred.numerical {
        solution.round_coefficients();
    }
    let number = centred.position.evaluate(&BTreeMap::new()).ok();
    let position = match (&centred.definition, number) {
        (None, _) if !centred.numerical => Position::Exact(centred.position.clone()),
        (None | Some(_), Some(number)) => Position::Number(number),
        (_, None) => Position::WhereReal(centred.position.clone()),
    };
    if centred.cross_well.is_none() {
        solution.validity.push(Note::Equilibrium { coordinate: x, position });
    }
    if let Some(definition) = &centred.definition {
        solution.definitions.insert(0, definition.clone());
    }
    solution.equilibrium = centred.position.clone();
    Ok(())
}

fn has_corners(force: &Expr) -> bool {
    use crate::expr::Function::{Absolute, Maximum, Minimum, Sign, Step};
    let corners = [Absolute, Maximum, Minimum, Sign, Step];
    corners.into_iter().any(|function| force.contains_function(function))
}

/// The refusal of a force that is not a polynomial in the coordinate, which names the terms that
/// are not.
fn not_polynomial(force: &Expr, coordinate: Symbol, method: Method) -> Refusal {
    let constant = fresh("c", &[coordinate]);
    let is_none = |term: &Expr, constants: bool| {
        let mut name =
            |factor: &Expr| (constants && !factor.contains(coordinate)).then_some(constant);
        match term.to_polynomial(&mut name) {
            Ok(Some(polynomial)) => {
                polynomial.exponent_range(coordinate).is_some_and(|(lowest, _)| lowest < 0)
            }
            Ok(None) | Err(_) => true,
        }
    };
    let expanded = force.expand().unwrap_or_else(|_| force.clone());
    // A constant such as sqrt(k) is an obstacle to some methods, and is named if no other term is
    // one.
    let found = [true, false].map(|constants| {
        let terms = expanded.terms().iter().filter(|term| is_none(term, constants));
        Expr::sum(terms.cloned())
    });
    let term = found.iter().find(|terms| !terms.is_zero()).unwrap_or(force);
    Reason::PolynomialOnly.to(method).about(term)
}

/// The term of a sum that a refusal names.
fn first_term(sum: &Expr) -> &Expr {
    sum.terms().first().unwrap_or(sum)
}

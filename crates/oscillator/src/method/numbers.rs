//! omega and the motion of an answer at given numbers, whatever kind of law it has.
//!
//! Polynomials, implicit relations and closed forms are evaluated; a balance of harmonics, a law
//! that is an integral, the exact motion and the choice of hbar in homotopy analysis are solved
//! for.

mod no_numbers;

use std::cell::OnceCell;
use std::collections::BTreeMap;

use num_traits::Zero as _;

pub use no_numbers::NoNumbers;

use super::convergence_control::{FormulaInHbar, LeastResidual};
use super::exact_motion::{cosines, motion_about};
use super::table::{Choice, MethodEntry, MotionEvaluation};
use super::{balance, first_order, harmonic_balance, homotopy_analysis, inertia, one_term};
use crate::conservative::force::CentredForce;
use crate::conservative::is_odd;
use crate::decimal::significant;
use crate::exact::{Doubles, Polynomial};
use crate::expr::{CompiledFunction, EvaluationError, Expr, Rounded};
use crate::numeric::ode::energy::PeriodError;
use crate::oscillator::Oscillator;
use crate::series::FourierSeries;
use crate::solution::{AmplitudeConvention, Branch, Counts, Method, Solution};
use crate::symbol::Symbol;
use crate::symbol::letters::AMPLITUDE;

/// The relative rounding error above which a closed form is set aside for the integral it stands
/// for.
const LOST_DIGITS: f64 = 1e-13;

/// The relative rounding error of omega^2 from which on a formula is refused: its terms cancel.
const NO_DIGITS: f64 = 1e-6;

/// An answer in numbers.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Numbers {
    /// omega^2, of either sign.
    pub frequency_squared: f64,
    /// Bound of the relative change of omega^2 by rounding of the coefficients of the formula; zero
    /// if omega^2 is solved for numerically.
    pub rounding: f64,
    /// The motion in theta; `None` if the frequency is not real.
    pub motion: Option<FourierSeries<Doubles>>,
    /// Values that were chosen or solved for: hbar, the coefficients of a balance.
    pub chosen: Vec<(Symbol, f64)>,
    /// A remark on these numbers for the reader.
    pub remark: Option<String>,
}

/// The values with which the formulas of an answer are evaluated.
#[derive(Clone, Debug)]
pub struct SymbolValues {
    /// Every symbol of the formulas that has a real value: parameters and amplitude, what was
    /// chosen, definitions, omega, pi. Laws that are written for positive amplitudes have the size
    /// of a negative one here.
    pub values: Vec<(Symbol, f64)>,
    /// theta at `t = 0`: pi where the amplitude stands with its size instead of itself, else 0.
    pub phase: f64,
}

/// Results shared between amplitudes, all else being the same: a balance continues from its last
/// solution, the force at rest is analysed once, and the fractions of a formula in hbar are converted
/// once.
#[derive(Default)]
pub struct NumbersCache {
    balance: balance::Continuation,
    force: OnceCell<Option<CentredForce>>,
    formula: OnceCell<Option<FormulaInHbar>>,
}

impl NumbersCache {
    /// The force about the equilibrium of an answer; `None` if a symbol of it has no number.
    fn force(
        &self,
        oscillator: &Oscillator,
        solution: &Solution,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Option<CentredForce> {
        let amplitude = amplitude_of(solution, numbers);
        let known = self.force.get_or_init(|| {
            let (force, coordinate) = (&oscillator.force, oscillator.coordinate);
            CentredForce::new(force, coordinate, &solution.equilibrium, numbers, amplitude)
        });
        Some(known.as_ref()?.with_amplitude(amplitude))
    }
}

/// omega^2 and the motion of `solution`, an answer for `oscillator`, with `numbers` for the
/// parameters and the amplitude.
///
/// # Errors
/// [`NoNumbers`], in words for a user.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::{Options, Oscillator, method::numbers::evaluate, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options { order: Some(1), ..Options::default() })?;
/// let numbers = evaluate(&duffing, &solution, &[("A".into(), 1.0), ("eps".into(), 0.1)].into())?;
/// assert!((numbers.frequency_squared - 1.075).abs() < 1e-14); // 1 + 3*A^2*eps/4
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn evaluate(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Numbers, NoNumbers> {
    let known = &NumbersCache::default();
    let mut chosen = Vec::new();
    let mut numbers = in_own_amplitude(solution, numbers);
    if let Some(hbar) = open_hbar(solution, &numbers) {
        let value = best_hbar(oscillator, solution, &numbers, hbar, known)?.hbar;
        numbers.insert(hbar, value);
        chosen.push((hbar, value));
    }
    if solution.law.is_solved_by_numbers() {
        let (frequency_squared, motion, remark) = solve(oscillator, solution, &numbers, known)?;
        return Ok(Numbers {
            frequency_squared,
            rounding: 0.0,
            chosen: balanced(solution, &motion, &numbers),
            motion: (frequency_squared > 0.0).then_some(motion),
            remark,
        });
    }
    let (squared, rounding) = frequency_squared(oscillator, solution, &numbers, known)?;
    if rounding > NO_DIGITS && squared != 0.0 {
        return Err(NoNumbers::Cancels { rounding });
    }
    let motion = match MethodEntry::for_method(solution.method).motion {
        MotionEvaluation::Exact if squared > 0.0 => {
            exact_motion(oscillator, solution, &numbers, known).ok().map(|found| found.1)
        }
        MotionEvaluation::Exact => None,
        // The frequency alone.
        MotionEvaluation::Formula if solution.displacement.is_zero() => None,
        _ => formula_motion(oscillator, solution, &numbers, squared),
    };
    Ok(Numbers { frequency_squared: squared, rounding, motion, chosen, remark: None })
}

/// omega^2 alone, without the motion if that costs more. Cancellation of its terms is not refused, so
/// that its zeros can be bracketed.
///
/// # Errors
/// As [`evaluate`].
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::{Options, Oscillator, method::numbers::frequency_squared_of, solve};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options { order: Some(2), ..Options::default() })?;
/// let square = frequency_squared_of(&pendulum, &solution, &[("A".into(), 1.0)].into())?;
/// assert!((square - 0.875).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn frequency_squared_of(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<f64, NoNumbers> {
    frequency_squared_along(oscillator, solution, numbers, &NumbersCache::default())
}

/// As [`frequency_squared_of`] for one amplitude after the other, all else being the same: a
/// balance goes on from where it was.
///
/// # Errors
/// As [`evaluate`].
pub fn frequency_squared_along(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    known: &NumbersCache,
) -> Result<f64, NoNumbers> {
    let mut numbers = in_own_amplitude(solution, numbers);
    if let Some(hbar) = open_hbar(solution, &numbers) {
        let best = best_hbar(oscillator, solution, &numbers, hbar, known)?;
        let squared = best.frequency * best.frequency.abs();
        // Only the reason why there is no value is sought in the formula itself.
        if squared.is_finite() {
            return Ok(squared);
        }
        numbers.insert(hbar, best.hbar);
    }
    match solution.law.is_solved_by_numbers() {
        true => solve(oscillator, solution, &numbers, known).map(|found| found.0),
        false => frequency_squared(oscillator, solution, &numbers, known).map(|found| found.0),
    }
}

/// The numbers with the amplitude that a formula measures: that of the first harmonic, where only
/// `A = x(0) - equilibrium` is given, by the formula's own motion solved for it as a series of the
/// same order.
fn in_own_amplitude(solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> BTreeMap<Symbol, f64> {
    let mut numbers = numbers.clone();
    let [initial, own] =
        [AmplitudeConvention::Initial, solution.amplitude].map(AmplitudeConvention::symbol);
    if initial == own || numbers.contains_key(&own) || !numbers.contains_key(&initial) {
        return numbers;
    }
    // The initial displacement beside the amplitude and the equilibrium, by the power of the
    // amplitude and by the order: each term is marked by the small parameters, or by the amplitude
    // itself.
    let in_amplitude = solution.small_parameter == own;
    let one: Polynomial = Polynomial::symbol(own);
    let mut beside: BTreeMap<(i32, i32), Polynomial> = BTreeMap::new();
    for (monomial, number) in solution.displacement.at_zero().constant_term().terms() {
        let power = monomial.exponent(own);
        if power > 0 && one.coefficient(monomial).is_zero() {
            let order = if in_amplitude { power - 1 } else { solution.order_of(monomial) };
            let terms = beside.entry((power, order)).or_insert_with(Polynomial::zero);
            terms.add_term(monomial.without(own), -number.clone());
        }
    }
    let value_of = |polynomial: &Polynomial| {
        solution.evaluate(polynomial, &|name| numbers.get(&name).copied())
    };
    let beside: Result<Vec<_>, Symbol> = beside
        .iter()
        .map(|(&(power, order), terms)| Ok((power, order, value_of(terms)?)))
        .collect();
    if let Ok(beside) = beside {
        let value = solved_as_series(numbers[&initial], &beside, solution.order);
        numbers.insert(own, value);
    }
    numbers
}

/// `a` of `a = first + sum c d^k a^n`, of which `beside` are the `(n, k, c)`, as a series in `d` up
/// to its power `order`, at `d = 1`. Every pass gets one more power right.
fn solved_as_series(first: f64, beside: &[(i32, i32, f64)], order: u32) -> f64 {
    let mut series = vec![first];
    for pass in 1..=order as usize {
        let product = |one: &[f64], other: &[f64]| -> Vec<f64> {
            (0..=pass)
                .map(|k| (0..=k).filter_map(|j| Some(one.get(j)? * other.get(k - j)?)).sum())
                .collect()
        };
        let highest = beside.iter().map(|term| term.0).max().unwrap_or(0);
        let mut next = vec![0.0; pass + 1];
        next[0] = first;
        let mut raised = vec![1.0];
        for power in 1..=highest {
            raised = product(&raised, &series);
            for &(_, shift, factor) in beside.iter().filter(|term| term.0 == power) {
                let shifted = next.iter_mut().skip(usize::try_from(shift).unwrap_or(0));
                shifted.zip(&raised).for_each(|(sum, value)| *sum += factor * value);
            }
        }
        series = next;
    }
    series.iter().sum()
}

/// The symbol of homotopy analysis that is to be chosen, where there is one.
fn open_hbar(solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Option<Symbol> {
    let hbar = homotopy_analysis::convergence_control(solution);
    let open = MethodEntry::for_method(solution.method).takes(Choice::Hbar)
        && !numbers.contains_key(&hbar);
    (open && contains(solution, hbar)).then_some(hbar)
}

/// The coefficients of a balance, by their names; the equilibrium is no part of the mean.
fn balanced(
    solution: &Solution,
    motion: &FourierSeries<Doubles>,
    numbers: &BTreeMap<Symbol, f64>,
) -> Vec<(Symbol, f64)> {
    if MethodEntry::for_method(solution.method).motion != MotionEvaluation::Balance {
        return vec![];
    }
    let equilibrium = solution.equilibrium.evaluate(numbers).unwrap_or(0.0);
    let valued = |(k, name): (usize, Symbol)| {
        let value = motion.cosine(k).mean().0;
        (name, if k == 0 { value - equilibrium } else { value })
    };
    solution.balanced_harmonics().into_iter().map(valued).collect()
}

fn contains(solution: &Solution, symbol: Symbol) -> bool {
    let laws = solution.law.frequency().into_iter().chain(solution.law.frequency_squared());
    laws.into_iter().any(|law| law.symbols().contains(&symbol))
        || solution.displacement.harmonics().iter().any(|entry| entry.1.symbols().contains(&symbol))
}

/// Laws of one term are written for positive amplitudes: a negative one is half a period away.
fn by_size(solution: &Solution) -> bool {
    solution.law.relation().is_none()
        && solution.amplitude == AmplitudeConvention::Initial
        && !MethodEntry::for_method(solution.method).signed
        || is_first_order(solution)
}

/// Whether the law of an answer is one of the size of the amplitude.
pub fn law_takes_size(oscillator: &Oscillator, solution: &Solution) -> bool {
    // The quadratic force alone has an exact law that knows the sign of A, by eps*A.
    by_size(solution) && (!is_exact(solution) || is_odd_equation(oscillator))
}

/// Whether the motion of an answer is written for the size of the amplitude; polynomials in the
/// amplitude know its sign.
pub fn motion_takes_size(oscillator: &Oscillator, solution: &Solution) -> bool {
    by_size(solution) && !matches!(oscillator.polynomial_degree(), Ok(Some(_)))
}

/// Whether an expansion stopped at the projection of a force that is not a polynomial.
fn is_first_order(solution: &Solution) -> bool {
    // The series itself always has omega beside omega^2.
    solution.method.counts() == Counts::Powers && solution.law.frequency().is_none()
}

/// Whether the law is that of the true motion.
fn is_exact(solution: &Solution) -> bool {
    MethodEntry::for_method(solution.method).motion == MotionEvaluation::Exact
}

/// Whether the law is that of a motion `A cos(theta)`.
fn of_one_term(solution: &Solution) -> bool {
    by_size(solution) && !is_exact(solution) && solution.law.system().is_none()
}

/// The law that the frequency of an answer is taken from: `omega^2`, of which it is the root, or
/// `omega`.
pub fn law_name(solution: &Solution) -> &'static str {
    // Laws that are solved numerically give omega itself, but the one-term laws, which are
    // integrals for omega^2, give that.
    let by_integral = solution.law.quadrature().is_some() && solution.method != Method::Exact;
    match solution.law.closed_form() {
        _ if solution.law.frequency_squared().is_some()
            || solution.law.relation().is_some()
            || by_integral =>
        {
            "omega^2"
        }
        Some(form) if form.squared => "omega^2",
        _ => "omega",
    }
}

/// The amplitude; one where the law is free of it and none is given.
fn amplitude_of(solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> f64 {
    numbers.get(&solution.amplitude.symbol()).copied().unwrap_or(1.0)
}

/// omega^2, and how far rounding of the formula may move it, relatively.
fn frequency_squared(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    known: &NumbersCache,
) -> Result<(f64, f64), NoNumbers> {
    let symbol = solution.amplitude.symbol();
    if of_one_term(solution) {
        stays_defined(oscillator, solution, numbers, known)?;
    }
    if is_exact(solution) {
        // The law itself says nothing of whether the motion comes back.
        let force = known.force(oscillator, solution, numbers).ok_or(NoNumbers::NoValue)?;
        let start = amplitude_of(solution, numbers);
        let turns = force.turning_point(start);
        turns.map_err(|error| force.why_no_period(start, error))?;
    }
    let sized = law_takes_size(oscillator, solution);
    let value_of = |name| {
        let value = numbers.get(&name).copied()?;
        Some(if sized && name == symbol { value.abs() } else { value })
    };
    if solution.law.frequency_squared().is_none() && solution.law.relation().is_some() {
        return match solution.branch_at(&value_of) {
            Some(Branch::At { squared, rounding }) => Ok((squared, rounding)),
            Some(Branch::Ends(amplitude)) => Err(NoNumbers::BranchEnds { amplitude }),
            Some(Branch::NoneOfFirstOrder) => Err(NoNumbers::NoneOfFirstOrder),
            None => Err(NoNumbers::NoValue),
        };
    }
    let value = solution.frequency_squared_at(&value_of);
    let mut rounding = solution.rounding_at(&value_of).unwrap_or(0.0);
    if let Some(form) = solution.law.closed_form() {
        let value_of = |name| rounded(solution, name, &value_of);
        let found = form.value.evaluate_rounded(&value_of);
        let error =
            found.filter(|found| found.0.is_finite()).map(|(value, error)| error / value.abs());
        if error.is_none_or(|error| error.is_nan() || error > LOST_DIGITS)
            && let Some(better) = by_definition(oscillator, solution, numbers, known)
            && error.is_none_or(|error| error.is_nan() || better.1 <= error)
        {
            return Ok(better);
        }
        rounding = rounding.max(error.unwrap_or(0.0));
    }
    let undefined = || {
        let missing = solution.defined_values(&value_of).err()?;
        let mut names = solution.definitions.iter().map(|definition| definition.symbol);
        names.find(|name| *name == missing)
    };
    // The reason for which the exact motion is refused is reported rather than that its formula has
    // no value.
    let no_motion = || match is_exact(solution) {
        true => exact_motion(oscillator, solution, numbers, known).err(),
        false => None,
    };
    let value = value.filter(|value| value.is_finite()).ok_or_else(|| {
        match (undefined(), overflow(oscillator, solution, numbers, known)) {
            (_, Some(error)) => error,
            (Some(name), _) => NoNumbers::Undefined { name },
            (None, _) => no_motion().unwrap_or(NoNumbers::NoValue),
        }
    })?;
    Ok((value, rounding))
}

/// The value of a symbol or of a definition, with its rounding error.
fn rounded(
    solution: &Solution,
    name: Symbol,
    value_of: &dyn Fn(Symbol) -> Option<f64>,
) -> Option<Rounded> {
    match value_of(name) {
        Some(value) => Some((value, 0.0)),
        None => match solution.definitions.iter().find(|own| own.symbol == name) {
            // One may use those before it.
            Some(own) => own.meaning.evaluate_rounded(&|name| rounded(solution, name, value_of)),
            None => {
                let value = solution.evaluate(&Polynomial::symbol(name), value_of).ok()?;
                Some((value, f64::EPSILON * value.abs()))
            }
        },
    }
}

/// A motion of one term runs from `-A` to `A`: on all of that the force must be defined and finite.
fn stays_defined(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    known: &NumbersCache,
) -> Result<(), NoNumbers> {
    if matches!(oscillator.polynomial_degree(), Ok(Some(_))) {
        return Ok(());
    }
    let (Some(force), Some(amplitude)) =
        (known.force(oscillator, solution, numbers), numbers.get(&solution.amplitude.symbol()))
    else {
        return Ok(());
    };
    match force.gap(-amplitude.abs(), amplitude.abs()) {
        // Beyond double precision the force has a value that a law may not need.
        Some(place) if force.overflow(place - force.equilibrium()).is_some() => Ok(()),
        Some(place) => Err(NoNumbers::Gap { coordinate: oscillator.coordinate, place }),
        None => Ok(()),
    }
}

/// The part of the force that is beyond double precision along a motion of one term; `None` if
/// there is none.
fn overflow(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    known: &NumbersCache,
) -> Option<NoNumbers> {
    let force = known.force(oscillator, solution, numbers)?;
    let amplitude = amplitude_of(solution, numbers);
    let found = |place: f64| {
        let term = force.overflow(place)?;
        Some(PeriodError::Overflow { place, term }.moved(force.equilibrium()).into())
    };
    [amplitude, -amplitude].into_iter().find_map(found)
}

/// A law of one term by what defines it, without the differences of a closed form; with a bound of
/// its error, relative.
fn by_definition(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    known: &NumbersCache,
) -> Option<(f64, f64)> {
    let size = numbers.get(&solution.amplitude.symbol())?.abs();
    if is_exact(solution) {
        return exact_motion(oscillator, solution, numbers, known).ok().map(|found| (found.0, 0.0));
    }
    let force = if is_first_order(solution) {
        let force = first_order::truncated(oscillator, solution.small_parameter)?;
        CentredForce::new(&force, oscillator.coordinate, &solution.equilibrium, numbers, size)?
    } else {
        known.force(oscillator, solution, numbers)?
    };
    let definition = MethodEntry::for_method(solution.method).definition?;
    definition(&force, size).filter(|law| law.0.is_finite())
}

/// The relative error of the integral of a law of one term, as its quadrature estimates it; `None`
/// for other laws.
pub fn error_of_integral(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<f64> {
    let other =
        [Method::Exact, Method::HarmonicBalance, Method::EnergyBalance].contains(&solution.method);
    if solution.law.quadrature().is_none() || other {
        return None;
    }
    let amplitude = numbers.get(&solution.amplitude.symbol())?.abs();
    let force = NumbersCache::default().force(oscillator, solution, numbers)?;
    let (value, change) = one_term::coefficient_by_quadrature(&|y| force.value(y), amplitude, 1);
    Some((change / value).abs().max(1e-15))
}

/// Whether the equation changes its sign with the coordinate.
pub fn is_odd_equation(oscillator: &Oscillator) -> bool {
    is_odd(&oscillator.force, oscillator.coordinate).unwrap_or(false)
}

/// The motion by the formula, in theta; implicit methods write it with `omega`.
fn formula_motion(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    squared: f64,
) -> Option<FourierSeries<Doubles>> {
    if squared <= 0.0 {
        return None;
    }
    if let Some(motion) = iterate_by_definition(oscillator, solution, numbers, squared) {
        return Some(motion);
    }
    let (omega, amplitude) = (Symbol::new("omega"), solution.amplitude.symbol());
    let turned = is_turned(oscillator, solution, numbers);
    let value = |symbol| {
        if symbol == omega {
            return Some(squared.sqrt());
        }
        let value = numbers.get(&symbol).copied()?;
        Some(if turned && symbol == amplitude { -value } else { value })
    };
    let motion = solution.motion(&value).ok()?;
    if !turned {
        return Some(motion);
    }
    let motion = motion.by_harmonic(half_a_period);
    if is_odd_equation(oscillator) {
        return Some(motion);
    }
    // Every harmonic comes with a cos(theta) that lets the motion start at the amplitude; half a
    // period later the even ones, which have kept their signs, need it with the other sign.
    let start = solution.equilibrium.evaluate(numbers).ok()? + numbers.get(&amplitude)?;
    let missing = start - motion.evaluate(0.0);
    Some(motion.sum(&FourierSeries::from_parts(Doubles, vec![0.0, missing], vec![])))
}

/// Whether the motion is that of the size of the amplitude, half a period later.
fn is_turned(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> bool {
    let negative = numbers.get(&solution.amplitude.symbol()).is_some_and(|value| *value < 0.0);
    negative && motion_takes_size(oscillator, solution)
}

/// The coefficient of harmonic `k` half a period later.
pub fn half_a_period(k: usize, value: f64) -> f64 {
    if k % 2 == 1 { -value } else { value }
}

/// The values of all symbols that the formulas of an answer are written with, of which `found` are
/// the numbers, if it has any.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::{Oscillator, method::{Options, numbers::{evaluate, symbol_values}, solve}};
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options { order: Some(2), ..Options::default() })?;
/// let at = [("A".into(), 1.0)].into();
/// let found = evaluate(&pendulum, &solution, &at)?;
/// let known = symbol_values(&pendulum, &solution, &at, Some(&found));
/// let omega = known.values.iter().find(|(name, _)| name.name() == "omega").unwrap().1;
/// assert!((omega * omega - 0.875).abs() < 1e-14); // 1 - A^2/8
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn symbol_values(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    found: Option<&Numbers>,
) -> SymbolValues {
    let amplitude = solution.amplitude.symbol();
    let evaluated = !solution.law.is_solved_by_numbers() && !is_exact(solution);
    let turned = evaluated && is_turned(oscillator, solution, numbers);
    let sized = |(&name, &value): (&Symbol, &f64)| match turned && name == amplitude {
        true => (name, -value),
        false => (name, value),
    };
    // A limit cycle is free of the amplitude.
    let known =
        numbers.iter().filter(|entry| solution.limit_cycle.is_none() || *entry.0 != amplitude);
    let mut values: Vec<(Symbol, f64)> = known.map(sized).collect();
    values.extend(found.into_iter().flat_map(|found| found.chosen.iter().copied()));
    let squared = found.map(|found| found.frequency_squared);
    let lost = squared.and_then(|squared| lost_projections(oscillator, solution, numbers, squared));
    let lost: Vec<(Symbol, f64)> = lost
        .into_iter()
        .flatten()
        .filter_map(|(k, value)| {
            let name = projection_name(solution, k)?;
            Some((name, if turned { half_a_period(k, value) } else { value }))
        })
        .collect();
    // A definition may use those before it.
    for definition in &solution.definitions {
        let name = definition.symbol;
        if values.iter().any(|entry| entry.0 == name) {
            continue;
        }
        let by_definition = lost.iter().find(|entry| entry.0 == name).map(|entry| entry.1);
        let value = by_definition
            .or_else(|| definition.meaning.evaluate(&values.iter().copied().collect()).ok());
        values.extend(value.filter(|value| value.is_finite()).map(|value| (name, value)));
    }
    values.extend(squared.map(|squared| (Symbol::new("omega"), squared.sqrt())));
    let pi = Symbol::new("pi");
    let harmonics = solution.displacement.harmonics();
    let motion = harmonics.iter().flat_map(|entry| [&entry.1, &entry.2]);
    let cycle = solution.limit_cycle.iter().map(|cycle| &cycle.amplitude);
    let mut polynomials = solution.law.polynomials().chain(motion).chain(cycle);
    if polynomials.any(|polynomial| polynomial.symbols().contains(&pi)) {
        values.push((pi, std::f64::consts::PI));
    }
    let phase = if turned { std::f64::consts::PI } else { 0.0 };
    SymbolValues { values, phase }
}

/// The name that a first iterate gives to `c_k`: what stands over omega^2 in the harmonic, alone.
fn projection_name(solution: &Solution, k: usize) -> Option<Symbol> {
    let omega = Symbol::new("omega");
    let (_, cosine, _) =
        solution.displacement.harmonics().into_iter().find(|entry| entry.0 == k)?;
    let alone = cosine.terms().filter_map(|(monomial, _)| match *monomial.factors() {
        [(name, 1), (over, -2)] | [(over, -2), (name, 1)] if over == omega => Some(name),
        _ => None,
    });
    let mut defined = alone
        .filter(|&name| solution.definitions.iter().any(|definition| definition.symbol == name));
    defined.next()
}

/// `x_1 = A cos theta + sum c_k (cos k theta - cos theta)/((k^2 - 1) omega^2)` with the `c_k` by
/// quadrature, where their closed forms have lost digits that show beside the amplitude.
fn iterate_by_definition(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    squared: f64,
) -> Option<FourierSeries<Doubles>> {
    let projections = lost_projections(oscillator, solution, numbers, squared)?;
    let amplitude = *numbers.get(&solution.amplitude.symbol())?;
    let mut cosine = vec![0.0; solution.displacement.highest_harmonic().max(1) + 1];
    cosine[1] = amplitude;
    for (k, projection) in projections {
        // The constant term of the series is half of c_0.
        let divisor = if k == 0 { -2.0 } else { (k * k - 1) as f64 };
        let part = projection / (divisor * squared);
        cosine[k] += part;
        cosine[1] -= part;
    }
    let equilibrium = solution.equilibrium.evaluate(numbers).ok()?;
    cosine[0] += equilibrium;
    let finite = cosine.iter().all(|value| value.is_finite());
    finite.then(|| FourierSeries::from_parts(Doubles, cosine, vec![]))
}

/// The `c_k` of a first iterate by quadrature, where their closed forms have lost digits that show
/// beside the amplitude.
fn lost_projections(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    squared: f64,
) -> Option<Vec<(usize, f64)>> {
    if MethodEntry::for_method(solution.method).motion != MotionEvaluation::Iterate
        || solution.law.relation().is_some()
    {
        return None;
    }
    let symbol = solution.amplitude.symbol();
    let amplitude = *numbers.get(&symbol)?;
    let value_of = |name: Symbol| {
        let value = numbers.get(&name).copied()?;
        Some(if name == symbol { value.abs() } else { value })
    };
    let kept = solution.definitions.iter().all(|definition| {
        let value_of = |name| rounded(solution, name, &value_of);
        let found = definition.meaning.evaluate_rounded(&value_of);
        found.is_some_and(|(value, error)| {
            value.is_finite() && error <= LOST_DIGITS * squared * amplitude.abs()
        })
    });
    if kept {
        return None;
    }
    let force = NumbersCache::default().force(oscillator, solution, numbers)?;
    let harmonics = solution.displacement.harmonics().into_iter();
    let projections = harmonics.filter(|entry| entry.0 != 1);
    Some(projections.map(|(k, ..)| (k, one_term::coefficient(&force, amplitude, k).0)).collect())
}

/// Solves the laws that are not explicit: balances, integrals, the exact motion. The last value is
/// a remark.
fn solve(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    known: &NumbersCache,
) -> Result<(f64, FourierSeries<Doubles>, Option<String>), NoNumbers> {
    if oscillator.force.contains(oscillator.velocity()) {
        let found = || {
            let equilibrium = solution.equilibrium.evaluate(numbers).ok()?;
            let (squared, motion) = inertia::at_numbers(oscillator, solution, numbers)?;
            Some((squared, motion.sum(&FourierSeries::constant(Doubles, equilibrium)), None))
        };
        return found().ok_or(NoNumbers::NoValue);
    }
    if is_exact(solution) {
        return exact_motion(oscillator, solution, numbers, known)
            .map(|(squared, motion)| (squared, motion, None));
    }
    let given = || {
        let equilibrium = solution.equilibrium.evaluate(numbers).ok()?;
        let amplitude = *numbers.get(&solution.amplitude.symbol())?;
        Some((equilibrium, amplitude, known.force(oscillator, solution, numbers)?))
    };
    let (equilibrium, amplitude, force) = given().ok_or(NoNumbers::NoValue)?;
    let shift = FourierSeries::constant(Doubles, equilibrium);
    if MethodEntry::for_method(solution.method).motion == MotionEvaluation::Balance {
        let odd = solution.balanced_harmonics().iter().all(|entry| entry.0 % 2 == 1);
        let harmonics = harmonic_balance::harmonics(solution.order, odd);
        let degree = oscillator.polynomial_degree().ok().flatten();
        let found = balance::balance(&force, degree, &harmonics, amplitude, &known.balance)?;
        let remark = found.rest_ends_at.map(|end| {
            let end = significant(end, 6);
            match found.over_several_wells {
                true => format!("a balance about several wells: the one that continues from rest ends at {AMPLITUDE} = {end}"),
                false => format!(
                    "a balance followed down from large amplitudes: the one that continues from rest ends at {AMPLITUDE} = {end}"
                ),
            }
        });
        return Ok((found.frequency_squared, found.motion.sum(&shift), remark));
    }
    stays_defined(oscillator, solution, numbers, known)?;
    let (squared, error) =
        by_definition(oscillator, solution, numbers, known).ok_or(NoNumbers::NoValue)?;
    if error > NO_DIGITS {
        return Err(NoNumbers::Integral { error });
    }
    let motion = FourierSeries::from_parts(Doubles, vec![0.0, amplitude], vec![]);
    Ok((squared, motion.sum(&shift), None))
}

/// omega^2 and the motion by quadrature of the energy.
fn exact_motion(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    known: &NumbersCache,
) -> Result<(f64, FourierSeries<Doubles>), NoNumbers> {
    let force = known.force(oscillator, solution, numbers).ok_or(NoNumbers::NoValue)?;
    let start = amplitude_of(solution, numbers);
    let found = motion_about(&force, start);
    let (period, cosine) = found.map_err(|error| force.why_no_period(start, error))?;
    let frequency = std::f64::consts::TAU / period;
    // A motion that is written down is judged as it is written.
    let written = solution.closed_motion.as_ref();
    let written =
        written.and_then(|motion| harmonics_of_closed_form(solution, motion, numbers, frequency));
    Ok((
        frequency * frequency,
        FourierSeries::from_parts(Doubles, written.unwrap_or(cosine), vec![]),
    ))
}

/// The coefficients of `cos(k theta)` of a motion in closed form; `None` if it has no value.
fn harmonics_of_closed_form(
    solution: &Solution,
    motion: &Expr,
    numbers: &BTreeMap<Symbol, f64>,
    frequency: f64,
) -> Option<Vec<f64>> {
    let mut values = numbers.clone();
    values.extend(solution.defined_values(&|name| numbers.get(&name).copied()).ok()?);
    let time = Symbol::new("t");
    let names: Vec<Symbol> = std::iter::once(time).chain(values.keys().copied()).collect();
    let function = CompiledFunction::new(motion, &names).ok()?;
    let arguments: Vec<f64> = std::iter::once(0.0).chain(values.values().copied()).collect();
    let place = |theta: f64| {
        let mut arguments = arguments.clone();
        arguments[0] = theta / frequency;
        function.call(&arguments)
    };
    let cosine = cosines(&place);
    cosine.iter().all(|value| value.is_finite()).then_some(cosine)
}

/// The hbar at which the squared residual of the original equation is least.
fn best_hbar(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    hbar: Symbol,
    known: &NumbersCache,
) -> Result<LeastResidual, NoNumbers> {
    let force = known.force(oscillator, solution, numbers).ok_or(NoNumbers::NoValue)?;
    let mut numbers = numbers.clone();
    for definition in &solution.definitions {
        // Without a first frequency there is none for any hbar.
        let undefined = |error| match error {
            EvaluationError::MissingSymbol(_) => NoNumbers::NoValue,
            EvaluationError::Undefined { .. }
                if definition.meaning.overflow(&numbers).is_some() =>
            {
                NoNumbers::Beyond { name: definition.symbol }
            }
            EvaluationError::Undefined { .. } => NoNumbers::Undefined { name: definition.symbol },
        };
        let value = definition.meaning.evaluate(&numbers).map_err(undefined)?;
        numbers.insert(definition.symbol, value);
    }
    numbers.insert(Symbol::new("pi"), std::f64::consts::PI);
    let formula = known.formula.get_or_init(|| FormulaInHbar::new(solution, hbar));
    let best = formula
        .as_ref()
        .and_then(|formula| formula.least_residual(&force, |symbol| numbers.get(&symbol).copied()));
    best.ok_or(NoNumbers::NoValue)
}

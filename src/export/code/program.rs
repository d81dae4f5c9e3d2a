//! The program of an answer in any language: `angular_frequency` by the law that is judged,
//! `displacement` and its derivative `velocity`, and comments on them.

use std::collections::BTreeSet;

use num_traits::{Signed as _, Zero as _};

use super::{NoCode, Program, Routine, Statement, Value};
use crate::exact::rational::from_f64;
use crate::exact::{Doubles, Polynomial, Rational};
use crate::export::rounding_noise;
use crate::expr::{Expr, Function, Node, fresh};
use crate::method::numbers::{is_odd_equation, law_takes_size, motion_takes_size};
use crate::method::table::{MethodEntry, MotionEvaluation};
use crate::oscillator::Oscillator;
use crate::report::{self, Block, Document};
use crate::series::FourierSeries;
use crate::solution::note::ExactBy;
use crate::solution::{Definition, Note, Solution, Sum, definitions_behind};
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FREQUENCY as FREQUENCY_LETTER, of_frequency};
use crate::verify::Verification;

/// The reason why a balance of harmonics has no program without values.
pub(super) const SEVERAL_EQUATIONS: &str =
    "the frequency is a root of several equations, which numbers solve";

pub(super) const FREQUENCY: &str = "angular_frequency";
const DISPLACEMENT: &str = "displacement";
const VELOCITY: &str = "velocity";
const ABOUT_DISPLACEMENT: &str = "The displacement at the time t, equilibrium included";
const ABOUT_VELOCITY: &str = "Its derivative, the velocity at the time t";

/// Greatest length of a line of the header, in characters.
const WIDTH: usize = 96;

/// The program of an answer.
pub(super) fn of_solution(
    oscillator: &Oscillator,
    solution: &Solution,
    verification: Option<&Verification>,
) -> Result<Program, NoCode> {
    if solution.response.is_some() {
        return Err(NoCode::Driven);
    }
    if solution.slow().is_some() {
        return Err(NoCode::Slow);
    }
    let amplitude = solution.amplitude.symbol();
    let names = ProgramNames::new(amplitude, solution.phase(), &solution.names());
    let mut header = header(solution, verification);
    let mut remarks: Vec<String> = Vec::new();
    let formula = formula(solution);
    let is_exact = MethodEntry::for_method(solution.method).motion == MotionEvaluation::Exact;
    let mut routines = Vec::new();
    match (&formula, verification) {
        (Ok(law), _) => {
            let frequency = frequency(oscillator, solution, &names, law);
            let arguments = frequency.arguments.clone();
            routines.push(frequency);
            if let Some(motion) = &solution.closed_motion {
                routines.extend(written_motion(solution, &names, motion)?);
            } else if !solution.displacement.is_zero() {
                routines.extend(motion(oscillator, solution, &names, &arguments));
            }
            share_arguments(&names, &mut routines);
            remarks.extend(unchecked_conditions(oscillator, solution));
            remarks.extend(at_rest(solution, law));
        }
        (Err(reason), None) => return Err(NoCode::SolvedByNumbers(reason.clone())),
        (Err(_), Some(verification)) => routines.push(constant_frequency(verification)?),
    }
    let by_numbers = formula.is_err() || (is_exact && solution.closed_motion.is_none());
    match verification {
        Some(verification) if by_numbers => {
            let numbers = verification.motion.as_ref().zip(verification.frequency);
            let no_motion =
                || NoCode::NoMotion(verification.reason.as_ref().map(ToString::to_string));
            let (motion, frequency) = numbers.ok_or_else(no_motion)?;
            routines.extend(motion_in_numbers(&names, motion, frequency));
            let at: Vec<String> =
                verification.at.iter().map(|(name, value)| format!("{name} = {value}")).collect();
            let what = if formula.is_err() { "Everything" } else { "The motion" };
            remarks.push(format!("{what} is in numbers, which hold at {} alone.", at.join(", ")));
        }
        None if by_numbers => {
            remarks.push(
                "The motion follows by quadrature of the energy: at given values it is here in numbers.".to_owned(),
            );
        }
        _ => {}
    }
    if !remarks.is_empty() {
        header.push(String::new());
        header.extend(remarks.iter().flat_map(|remark| wrapped(remark)));
    }
    Ok(Program { header, routines })
}

/// Gives every function the same arguments, whether it needs them or not, after the time of a
/// motion.
pub(super) fn share_arguments(names: &ProgramNames, routines: &mut [Routine]) {
    let mut all: Vec<Symbol> = vec![];
    // The motion has the most, in the order of their names.
    for routine in routines.iter().rev() {
        let new = |name: &&Symbol| **name != names.time && !all.contains(name);
        let new: Vec<Symbol> = routine.arguments.iter().filter(new).copied().collect();
        all.extend(new);
    }
    for routine in routines {
        let needed = std::mem::take(&mut routine.arguments);
        let time = needed.first().filter(|name| **name == names.time);
        routine.arguments = time.into_iter().chain(&all).copied().collect();
        let mut passed_on = false;
        for statement in &mut routine.body {
            if let Statement::Variable(_, Value::Call(_, arguments)) = statement {
                arguments.clone_from(&all);
                passed_on = true;
            }
        }
        if !passed_on {
            let unused = all.iter().filter(|name| !needed.contains(name)).copied();
            routine.body.splice(0..0, unused.map(Statement::Unused));
        }
    }
}

/// The report of the answer without its formulas.
fn header(solution: &Solution, verification: Option<&Verification>) -> Vec<String> {
    let document = report::solution(solution, verification);
    let is_formula = |block: &Block| {
        let words = matches!(
            block,
            Block::Question(_)
                | Block::Title { .. }
                | Block::Heading(_)
                | Block::Note(_)
                | Block::Remark(_)
                | Block::CycleAmplitude { .. }
                | Block::Judged { .. }
        );
        !words
    };
    let sections = document.sections.into_iter().filter(|section| !section.iter().any(is_formula));
    lines_of(&Document { sections: sections.collect() })
}

/// A document as the lines of a header.
pub(super) fn lines_of(document: &Document) -> Vec<String> {
    let text = crate::export::text::document(document, WIDTH);
    text.trim_end().lines().flat_map(wrapped).collect()
}

/// A line wrapped to the width of the header, continuation lines being indented.
fn wrapped(line: &str) -> Vec<String> {
    let margin = line.len() - line.trim_start().len();
    let mut lines = vec![String::new()];
    for (index, word) in line.split(' ').enumerate() {
        let last = lines.last_mut().map_or(0, |last| last.len());
        if last + 1 + word.len() > WIDTH && last > margin + 4 {
            lines.push(format!("{}{word}", " ".repeat(margin + 4)));
        } else if let Some(last) = lines.last_mut() {
            if index > 0 {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines
}

/// The names of variables that a program introduces.
pub(super) struct ProgramNames {
    pub(super) amplitude: Symbol,
    pub(super) time: Symbol,
    pub(super) theta: Symbol,
    pub(super) omega: Symbol,
    omega_squared: Symbol,
    /// The displacement for the absolute value of the amplitude.
    shape: Symbol,
    /// dx/dtheta.
    slope: Symbol,
    /// A number that is positive if enough digits are left.
    digits: Symbol,
    /// The sign of the amplitude.
    sign: Symbol,
}

impl ProgramNames {
    /// The names beside those of a motion of this amplitude and phase, in which others are taken.
    pub(super) fn new(amplitude: Symbol, theta: Symbol, taken: &[Symbol]) -> Self {
        Self {
            amplitude,
            time: Symbol::new("t"),
            theta,
            omega: Symbol::new("omega"),
            omega_squared: fresh(&format!("{FREQUENCY_LETTER}_squared"), taken),
            shape: fresh("shape", taken),
            slope: fresh("slope", taken),
            digits: fresh("digits", taken),
            sign: fresh("direction", taken),
        }
    }
}

/// A law that can be computed.
struct Law {
    value: Value,
    expression: Expr,
    squared: bool,
}

/// The law that is judged, or the reason why it is not a formula.
fn formula(solution: &Solution) -> Result<Law, String> {
    let polynomial = |law: &Polynomial, squared| Law {
        value: ordered(solution, law),
        expression: Expr::from(law),
        squared,
    };
    let law = &solution.law;
    if let Some(squared) = law.frequency_squared() {
        return Ok(polynomial(squared, true));
    }
    let closed = match law.relation() {
        Some(_) => solution.closed_branch(),
        None => law.closed_form(),
    };
    if let Some(form) = closed {
        return Ok(Law {
            value: Value::Expression(form.value.clone()),
            expression: form.value.clone(),
            squared: form.squared,
        });
    }
    match law.frequency() {
        Some(frequency) => Ok(polynomial(frequency, false)),
        None if law.relation().is_some() => Err(format!(
            "the frequency is a root of a relation, which numbers follow from {AMPLITUDE} = 0 to the amplitude"
        )),
        None if law.system().is_some() => Err(SEVERAL_EQUATIONS.to_owned()),
        None => Err("the frequency is given by integrals, which numbers solve".to_owned()),
    }
}

/// A polynomial with its terms in reading order.
fn ordered(solution: &Solution, polynomial: &Polynomial) -> Value {
    in_order(&solution.ordered(polynomial))
}

/// A sum with its terms in their order.
pub(super) fn in_order(sum: &Sum) -> Value {
    let term = |(monomial, number): (&_, &Rational)| {
        let term: Polynomial = Polynomial::term(Clone::clone(monomial), number.clone());
        Value::Expression(Expr::from(&term))
    };
    Value::Sum(sum.terms().map(term).collect())
}

/// Resolves the symbols of a formula: the definitions behind them, and the arguments, the amplitude
/// first.
pub(super) fn resolved<'a>(
    definitions: &'a [Definition],
    names: &ProgramNames,
    symbols: BTreeSet<Symbol>,
) -> (Vec<&'a Definition>, Vec<Symbol>) {
    let definitions = definitions_behind(definitions, symbols.clone());
    let mut all = symbols;
    all.extend(definitions.iter().flat_map(|definition| definition.meaning.symbols()));
    for definition in &definitions {
        all.remove(&definition.symbol);
    }
    let own = [names.omega, names.theta, names.time, Symbol::new("pi")];
    all.retain(|symbol| !own.contains(symbol));
    let amplitude = all.take(&names.amplitude);
    (definitions, amplitude.into_iter().chain(all).collect())
}

pub(super) fn variables(definitions: Vec<&Definition>) -> impl Iterator<Item = Statement> + '_ {
    let variable = |definition: &Definition| {
        Statement::Variable(definition.symbol, Value::Expression(definition.meaning.clone()))
    };
    definitions.into_iter().map(variable)
}

/// Whether an expression, with its definitions written out, keeps or changes its sign with the
/// amplitude.
fn flips(solution: &Solution, expression: &Expr, negated: bool) -> bool {
    let amplitude = solution.amplitude.symbol();
    let written_out = |expression: &Expr| {
        let mut definitions = solution.definitions.iter().rev();
        definitions.try_fold(expression.clone(), |whole, definition| {
            whole.substitute(definition.symbol, &definition.meaning).ok()
        })
    };
    let turned = || {
        let whole = written_out(expression)?;
        let turned = whole.substitute(amplitude, &-Expr::from(amplitude)).ok()?;
        let turned = turned.expand().ok()?;
        let whole = whole.expand().ok()?;
        Some(turned == if negated { -whole } else { whole })
    };
    turned().unwrap_or(false)
}

fn frequency(
    oscillator: &Oscillator,
    solution: &Solution,
    names: &ProgramNames,
    law: &Law,
) -> Routine {
    let (definitions, arguments) = resolved(&solution.definitions, names, law.expression.symbols());
    let mut body = Vec::new();
    let by_size = arguments.contains(&names.amplitude) && law_takes_size(oscillator, solution);
    if by_size && !flips(solution, &law.expression, false) {
        body.push(Statement::Size(names.amplitude));
    }
    body.extend(variables(definitions));
    let value = Value::clone(&law.value);
    let result = match law.squared {
        true => {
            let remaining = digits(names, [&law.expression], names.omega_squared, &Expr::one());
            return root_of_square(names, arguments, body, value, remaining);
        }
        false => {
            body.push(Statement::Variable(names.omega, value));
            body.extend(digits(names, [&law.expression], names.omega, &Expr::one()));
            body.push(Statement::Positive(
                names.omega,
                names.omega,
                of_frequency("omega is not positive: there is no frequency"),
            ));
            Expr::from(names.omega)
        }
    };
    Routine {
        name: FREQUENCY.to_owned(),
        about: "The angular frequency in radians per unit of time".to_owned(),
        arguments,
        body,
        result: Value::Expression(result),
    }
}

/// The routine of a frequency whose square has a law: the statements before it, the law, and those
/// behind it that look whether digits remain.
pub(super) fn root_of_square(
    names: &ProgramNames,
    arguments: Vec<Symbol>,
    before: Vec<Statement>,
    law: Value,
    remaining: Vec<Statement>,
) -> Routine {
    let mut body = before;
    body.push(Statement::Variable(names.omega_squared, law));
    body.extend(remaining);
    body.push(Statement::Positive(
        names.omega_squared,
        names.omega_squared,
        of_frequency("omega^2 is not positive: there is no frequency"),
    ));
    let squared = Expr::from(names.omega_squared);
    Routine {
        name: FREQUENCY.to_owned(),
        about: of_frequency(
            "The angular frequency in radians per unit of time, the root of omega^2",
        ),
        arguments,
        body,
        result: Value::Expression(squared.sqrt().unwrap_or(squared)),
    }
}

/// The routine of a frequency that is only known as a number.
fn constant_frequency(verification: &Verification) -> Result<Routine, NoCode> {
    let no_motion = || NoCode::NoMotion(verification.reason.as_ref().map(ToString::to_string));
    let frequency = verification.frequency.ok_or_else(no_motion)?;
    Ok(Routine {
        name: FREQUENCY.to_owned(),
        about: "The angular frequency in radians per unit of time".to_owned(),
        arguments: vec![],
        body: vec![],
        result: number(frequency),
    })
}

fn number(value: f64) -> Value {
    Value::Expression(Expr::number(from_f64(value).unwrap_or_default()))
}

/// `cos(k*theta)`, or the sine.
fn wave(function: Function, k: usize, theta: Symbol) -> Value {
    let angle = Expr::from(i64::try_from(k).unwrap_or(i64::MAX)) * Expr::from(theta);
    let wave = Expr::function(function, vec![angle]);
    Value::Expression(wave.unwrap_or_else(|_| Expr::zero()))
}

/// A harmonic: `k` and the coefficients of the cosine and the sine; `None` for a zero coefficient.
pub(super) struct Harmonic {
    pub(super) k: usize,
    pub(super) cosine: Option<Value>,
    pub(super) sine: Option<Value>,
}

/// The terms of a motion.
fn terms(harmonics: Vec<Harmonic>, theta: Symbol) -> Vec<Value> {
    let mut terms = Vec::new();
    for harmonic in harmonics {
        for (coefficient, function) in
            [(harmonic.cosine, Function::Cos), (harmonic.sine, Function::Sin)]
        {
            match (coefficient, harmonic.k) {
                (None, _) => {}
                (Some(Value::Sum(parts)), 0) => terms.extend(parts),
                (Some(coefficient), 0) => terms.push(coefficient),
                (Some(coefficient), k) => {
                    terms.push(Value::Product(vec![coefficient, wave(function, k, theta)]))
                }
            }
        }
    }
    terms
}

/// The statements of a function of the motion before its result, and its arguments.
pub(super) struct FunctionPrologue {
    pub(super) arguments: Vec<Symbol>,
    pub(super) body: Vec<Statement>,
}

fn motion(
    oscillator: &Oscillator,
    solution: &Solution,
    names: &ProgramNames,
    of_frequency: &[Symbol],
) -> [Routine; 2] {
    let harmonics = solution.displacement.harmonics();
    let moving = harmonics.iter().filter(|entry| entry.0 > 0);
    let sign = sign_of_motion(oscillator, solution, names);
    let beginning = |symbols: BTreeSet<Symbol>| {
        let mut symbols = symbols;
        symbols.extend(of_frequency);
        if !matches!(sign, Sign::Any) {
            symbols.insert(names.amplitude);
        }
        let (definitions, mut arguments) = resolved(&solution.definitions, names, symbols);
        arguments.insert(0, names.time);
        let mut body = Vec::new();
        match sign {
            Sign::Any => {}
            Sign::Opposite | Sign::HalfPeriod => {
                let sign = Expr::function(Function::Sign, vec![Expr::from(names.amplitude)]);
                let sign = sign.unwrap_or_else(|_| Expr::one());
                body.push(Statement::Variable(names.sign, Value::Expression(sign)));
                body.push(Statement::Size(names.amplitude));
            }
        }
        body.extend(variables(definitions.clone()));
        body.push(Statement::Variable(
            names.omega,
            Value::Call(FREQUENCY.to_owned(), of_frequency.to_vec()),
        ));
        // A definition enters the motion divided by omega^2, so that the digits are compared with
        // omega^2 A.
        let scale = Expr::product([names.omega, names.amplitude].map(Expr::from));
        body.extend(digits(names, definitions.iter().map(|own| &own.meaning), names.omega, &scale));
        body.push(match sign {
            Sign::HalfPeriod => {
                Statement::Variable(names.theta, Value::Expression(turned_angle(names)))
            }
            Sign::Any | Sign::Opposite => angle(names),
        });
        FunctionPrologue { arguments, body }
    };
    let symbols =
        |(_, cosine, sine): &(usize, Polynomial, Polynomial)| [cosine.symbols(), sine.symbols()];
    let all: BTreeSet<Symbol> = harmonics.iter().flat_map(symbols).flatten().collect();
    let beginnings = match sign {
        // The correction by which the shifted motion begins at its amplitude contains all
        // harmonics.
        Sign::HalfPeriod => {
            let all = &all | &solution.equilibrium.symbols();
            [beginning(all.clone()), beginning(all)]
        }
        Sign::Any | Sign::Opposite => {
            [beginning(all), beginning(moving.clone().flat_map(symbols).flatten().collect())]
        }
    };
    let start = match sign {
        Sign::HalfPeriod => Some(missing_at_start(solution, names, &harmonics)),
        Sign::Any | Sign::Opposite => None,
    };
    let times = |polynomial: &Polynomial, factor: i64| {
        let factor = Rational::from_integer(factor.into());
        let scaled: Polynomial = polynomial.map(|number| number * &factor);
        (!scaled.is_zero()).then(|| ordered(solution, &scaled))
    };
    // The first harmonic includes the correction by which the shifted motion begins at its
    // amplitude.
    let cosines = |k: usize, cosine: &Polynomial, factor: i64| match (&start, k) {
        (Some(start), 1) => {
            let start = Value::Expression(Expr::from(factor) * start);
            let own = times(cosine, factor).into_iter();
            let parts = own.flat_map(|own| match own {
                Value::Sum(parts) => parts,
                other => vec![other],
            });
            Some(Value::Sum(parts.chain([start]).collect()))
        }
        _ => times(cosine, factor),
    };
    let displaced = harmonics.iter().map(|(k, cosine, sine)| Harmonic {
        k: *k,
        cosine: cosines(*k, cosine, 1),
        sine: times(sine, 1),
    });
    let moving = moving.map(|(k, cosine, sine)| {
        let factor = i64::try_from(*k).unwrap_or(i64::MAX);
        Harmonic { k: *k, cosine: times(sine, factor), sine: cosines(*k, cosine, -factor) }
    });
    let before = match sign {
        Sign::Opposite => Some(names.sign),
        _ => None,
    };
    displacement_and_velocity(names, beginnings, before, displaced.collect(), moving.collect())
}

/// Displacement and velocity of a motion that is an expression in the time.
fn written_motion(
    solution: &Solution,
    names: &ProgramNames,
    motion: &Expr,
) -> Result<[Routine; 2], NoCode> {
    let velocity = motion.differentiate(names.time).map_err(|_| NoCode::NoMotion(None))?;
    let routine = |name, about: &str, expression: &Expr| {
        let (definitions, mut arguments) =
            resolved(&solution.definitions, names, expression.symbols());
        arguments.insert(0, names.time);
        Routine {
            name: str::to_owned(name),
            about: about.to_owned(),
            arguments,
            body: variables(definitions).collect(),
            result: Value::Expression(expression.clone()),
        }
    };
    Ok([
        routine(DISPLACEMENT, ABOUT_DISPLACEMENT, motion),
        routine(VELOCITY, ABOUT_VELOCITY, &velocity),
    ])
}

/// `omega*t`, shifted by half a period for a negative amplitude.
fn turned_angle(names: &ProgramNames) -> Expr {
    let half = Expr::pi() * Expr::number(Rational::new(1.into(), 2.into()));
    Expr::from(names.omega) * Expr::from(names.time) + (Expr::one() - Expr::from(names.sign)) * half
}

/// The correction of the coefficient of `cos(theta)` for a negative amplitude: half a period later
/// the even harmonics keep their signs, and with this correction the motion begins at its
/// amplitude.
fn missing_at_start(
    solution: &Solution,
    names: &ProgramNames,
    harmonics: &[(usize, Polynomial, Polynomial)],
) -> Expr {
    let half = Expr::number(Rational::new(1.into(), 2.into()));
    let turned = harmonics.iter().map(|(k, cosine, _)| {
        let cosine = Expr::from(cosine);
        if k % 2 == 1 { -cosine } else { cosine }
    });
    let begins = &solution.equilibrium - &Expr::from(names.amplitude);
    // The angle is turned: its cosine at the start is -1.
    (Expr::one() - Expr::from(names.sign)) * half * (Expr::sum(turned) - begins)
}

/// `theta = omega*t`.
pub(super) fn angle(names: &ProgramNames) -> Statement {
    let angle = Expr::from(names.omega) * Expr::from(names.time);
    Statement::Variable(names.theta, Value::Expression(angle))
}

/// The routines of displacement and velocity; both begin with the statements `before`.
pub(super) fn displacement_and_velocity(
    names: &ProgramNames,
    beginnings: [FunctionPrologue; 2],
    before: Option<Symbol>,
    displaced: Vec<Harmonic>,
    moving: Vec<Harmonic>,
) -> [Routine; 2] {
    let before = before.map(|sign| Value::Expression(sign.into()));
    let times =
        |factors: Vec<Value>| Value::Product(before.clone().into_iter().chain(factors).collect());
    let [mut displacement, mut velocity] = beginnings;
    let terms_of_displacement = Value::Lines(terms(displaced, names.theta));
    let result = match before {
        None => terms_of_displacement,
        Some(_) => {
            let variable = Statement::Variable(names.shape, terms_of_displacement);
            displacement.body.push(variable);
            times(vec![Value::Expression(names.shape.into())])
        }
    };
    let displacement = Routine {
        name: DISPLACEMENT.to_owned(),
        about: ABOUT_DISPLACEMENT.to_owned(),
        arguments: displacement.arguments,
        body: displacement.body,
        result,
    };
    let mut slopes = terms(moving, names.theta);
    let omega = Value::Expression(names.omega.into());
    let result = match slopes.len() {
        1 => times(match slopes.remove(0) {
            Value::Product(factors) => std::iter::once(omega).chain(factors).collect(),
            slope => vec![omega, slope],
        }),
        _ => {
            velocity.body.push(Statement::Variable(names.slope, Value::Lines(slopes)));
            times(vec![omega, Value::Expression(names.slope.into())])
        }
    };
    let velocity = Routine {
        name: VELOCITY.to_owned(),
        about: ABOUT_VELOCITY.to_owned(),
        arguments: velocity.arguments,
        body: velocity.body,
        result,
    };
    [displacement, velocity]
}

/// The transformation of a motion to negative amplitudes, if its formula holds for the absolute
/// value of the amplitude.
enum Sign {
    /// The formula holds for either sign.
    Any,
    /// The motion changes its sign.
    Opposite,
    /// The motion is shifted by half a period, and corrected so that it begins at its amplitude.
    HalfPeriod,
}

fn sign_of_motion(oscillator: &Oscillator, solution: &Solution, names: &ProgramNames) -> Sign {
    let harmonics = solution.displacement.harmonics();
    let amplitude: Polynomial = Polynomial::symbol(names.amplitude);
    let of_one_term = harmonics.iter().all(|(k, cosine, sine)| match k {
        0 => {
            !Expr::from(cosine).contains(names.amplitude)
                && cosine.symbols().iter().all(|symbol| !is_of_amplitude(solution, *symbol, names))
        }
        1 => *cosine == amplitude && sine.is_zero(),
        _ => false,
    });
    if of_one_term || !motion_takes_size(oscillator, solution) {
        return Sign::Any;
    }
    let turns = |polynomial: &Polynomial| flips(solution, &Expr::from(polynomial), true);
    let is_odd = is_odd_equation(oscillator) && solution.equilibrium.is_zero();
    match is_odd {
        true if harmonics.iter().all(|entry| turns(&entry.1) && turns(&entry.2)) => Sign::Any,
        true => Sign::Opposite,
        false => Sign::HalfPeriod,
    }
}

/// Whether the definition of a symbol contains the amplitude.
fn is_of_amplitude(solution: &Solution, symbol: Symbol, names: &ProgramNames) -> bool {
    let behind = solution.definitions_behind(BTreeSet::from([symbol]));
    behind.iter().any(|definition| definition.meaning.contains(names.amplitude))
}

/// The motion at given values.
fn motion_in_numbers(
    names: &ProgramNames,
    motion: &FourierSeries<Doubles>,
    frequency: f64,
) -> [Routine; 2] {
    let coefficients: Vec<(usize, f64, f64)> = (0..=motion.highest_harmonic())
        .map(|k| (k, motion.cosine(k).mean().0, motion.sine(k).mean().0))
        .collect();
    let noise = rounding_noise(motion);
    let value = |coefficient: f64| (coefficient.abs() > noise).then(|| number(coefficient));
    let displaced = coefficients.iter().map(|&(k, cosine, sine)| Harmonic {
        k,
        cosine: value(cosine),
        sine: value(sine),
    });
    let moving =
        coefficients.iter().filter(|entry| entry.0 > 0).map(|&(k, cosine, sine)| Harmonic {
            k,
            cosine: value(sine).map(|_| number(k as f64 * sine)),
            sine: value(cosine).map(|_| number(-(k as f64) * cosine)),
        });
    let beginning = || FunctionPrologue {
        arguments: vec![names.time],
        body: vec![Statement::Variable(names.omega, number(frequency)), angle(names)],
    };
    displacement_and_velocity(
        names,
        [beginning(), beginning()],
        None,
        displaced.collect(),
        moving.collect(),
    )
}

/// Ends a function if the terms of its formulas cancel so far that more than half of the digits of
/// `value*scale` are lost: as the amplitude goes to zero, several of them become infinite and their
/// sum does not.
fn digits<'a>(
    names: &ProgramNames,
    formulas: impl IntoIterator<Item = &'a Expr>,
    value: Symbol,
    scale: &Expr,
) -> Vec<Statement> {
    /// Largest ratio of a term to the sum.
    const LARGEST: i64 = 1_000_000_000;
    let is_infinite = |term: &&Expr| term.substitute(names.amplitude, &Expr::zero()).is_err();
    let size = |formula: Expr| Expr::function(Function::Absolute, vec![formula]).ok();
    let mut sizes = Vec::new();
    for formula in formulas {
        let Ok(written_out) = formula.expand() else {
            continue;
        };
        let infinite: Vec<&Expr> = written_out.terms().iter().filter(is_infinite).collect();
        if infinite.len() > 1 {
            sizes.extend(infinite.into_iter().filter_map(|term| size(term.clone())));
        }
    }
    let whole = size(Expr::from(value) * scale).filter(|_| !sizes.is_empty());
    let Some(whole) = whole else { return vec![] };
    let left = Expr::from(LARGEST) * whole - Expr::sum(sizes);
    vec![
        Statement::Variable(names.digits, Value::Expression(left)),
        Statement::Positive(
            names.digits,
            value,
            "at so small an amplitude rounding takes the digits of the formula".to_owned(),
        ),
    ]
}

/// Conditions that a program, unlike a numerical answer, does not check: whether there is a motion,
/// and whether the force is defined all along it.
fn unchecked_conditions(oscillator: &Oscillator, solution: &Solution) -> Option<String> {
    let in_parts = |part: &Expr| match part.node() {
        Node::Function(function, _) => {
            use Function::{Acos, Asin, Log, Tan};
            [Acos, Asin, Log, Tan].contains(function)
        }
        Node::Power(base, exponent) => {
            let is_whole = exponent
                .as_number()
                .is_some_and(|number| number.is_integer() && number.is_positive());
            base.contains(oscillator.coordinate) && !is_whole
        }
        _ => false,
    };
    if solution.validity.contains(&Note::Exact(ExactBy::Linear)) {
        return None;
    }
    if MethodEntry::for_method(solution.method).motion == MotionEvaluation::Exact {
        return Some(
            "The program does not look whether the motion is periodic: where it is not, its numbers mean nothing."
                .to_owned(),
        );
    }
    let has_gaps =
        law_takes_size(oscillator, solution) && oscillator.force.unique_nodes().any(in_parts);
    has_gaps.then(|| {
        format!(
            "The program does not look whether the force is defined and finite from -{AMPLITUDE} to {AMPLITUDE}: where it is not, its numbers mean nothing."
        )
    })
}

/// A remark on a formula that has no value at rest; `None` if it has one.
fn at_rest(solution: &Solution, law: &Law) -> Option<String> {
    let amplitude = solution.amplitude.symbol();
    let limit = law.expression.substitute(amplitude, &Expr::zero());
    (law.expression.contains(amplitude) && limit.is_err()).then(|| {
        format!(
            "At {amplitude} = 0 the formula has no value, and close to it rounding takes digits."
        )
    })
}

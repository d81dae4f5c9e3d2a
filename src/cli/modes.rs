//! `lindstedt derive` of coupled equations: nonlinear normal modes.

use crate::coupled::CoupledEquations;
use crate::export::code::{self, CodeStyle};
use crate::export::{json, modes as drawing};
use crate::expr::{Expr, ResultSymbols, excerpt_of};
use crate::modes::{FreeSystem, ModeError, ModeOptions, NonlinearMode, NormalModes, derive};
use crate::problem::{Order, Problem, ReadingCommand};
use crate::report::{self, ModesReport};
use crate::solution::{AmplitudeConvention, Degrees, Method, defined_values};
use crate::symbol::Symbol;
use crate::values::Values;
use crate::verify::{JudgedMode, Verdict, VerificationError, judge_mode};

use super::answer::{Answer, no_such};
use super::derive::{
    DeriveArguments, EquationArguments, amplitude, as_meant, exact_values, prefix, unjudged,
};
use super::progress::with_progress;
use super::{Failure, Format, Outcome, files, json_text, session, tolerance};

/// Derives the modes of coupled equations, and judges them where values are given.
///
/// # Errors
/// Options that are those of one coordinate; equations that have no modes in formulas.
pub(super) fn run(
    arguments: &DeriveArguments,
    equations: CoupledEquations,
    problem: &Problem,
) -> Result<Outcome, Failure> {
    let question = &arguments.question;
    let method = question.method.as_deref().or(problem.method.as_deref());
    let order = question.order.or(problem.order);
    if method == Some(Method::HarmonicBalance.name())
        && equations.coordinates.len() == 2
        && matches!(order, None | Some(Order::Power(1)))
    {
        return super::one_harmonic::run(arguments, equations, problem);
    }
    let Derived { modes, values, letters } =
        derived(question, arguments.mode, arguments.steps, equations, problem)?;
    let _letters = letters.in_force();
    let tolerance = tolerance(&arguments.common);
    let asked =
        values.is_some() || arguments.common.draws() || arguments.common.tolerance.is_some();
    let needs_verdict = arguments.common.draws() || arguments.common.tolerance.is_some();
    let (judged, missing) = match asked {
        true => match judged(&modes, &values.unwrap_or_default(), tolerance) {
            // The formulas are an answer without their verdict.
            Err(VerificationError::Missing(names)) if !needs_verdict => (vec![], names),
            judged => (judged.map_err(|error| unjudged(&error))?, vec![]),
        },
        false => (vec![], vec![]),
    };
    let report = ModesReport { modes: &modes, judged: &judged, tolerance };
    let answer = Answer {
        document: &report::modes(&report),
        width: files::width(arguments.common.output.as_deref()),
        picture: Some(&|| Ok(drawing::picture(&report)?)),
        other: &|format| match format {
            Format::Json => json_text(&json::modes(&report)),
            Format::Code(language) => {
                let prefix = prefix(language, arguments.common.output.as_deref());
                let style = CodeStyle { language, prefix: &prefix };
                let program = code::modes(&report, style);
                program.map_err(|reason| Failure::with_advice(&reason, reason.help()))
            }
            format => no_such(format),
        },
    };
    let passes = |own: &Result<JudgedMode, String>| {
        own.as_ref().is_ok_and(|judged| judged.verdict == Verdict::Pass)
    };
    let verdicts = judged.iter().map(passes);
    let reached = modes.modes.iter().flatten().map(|mode| mode.order).min();
    let stopped = reached.filter(|reached| *reached < modes.order);
    let late = session::supervision().interrupt.is_requested() && stopped.is_none() && asked;
    let without_verdict = (!missing.is_empty()).then(|| without_verdict(&modes, &missing));
    Ok(Outcome {
        verdict: (!judged.is_empty())
            .then(|| Verdict::from_passed(verdicts.into_iter().all(|passes| passes))),
        note: match stopped {
            Some(reached) => Some(format!(
                "warning: stopped early, what there is is kept: order {reached} of {}",
                modes.order
            )),
            None if late => Some("warning: stopped early, what there is is kept".to_owned()),
            None => without_verdict,
        },
        partial: stopped.is_some() || late,
        ..answer.outcome(&arguments.common)?
    })
}

/// A note that names the values which a verdict on modes lacks.
fn without_verdict(modes: &NormalModes, missing: &[Symbol]) -> String {
    let amplitudes: Vec<Symbol> =
        modes.modes.iter().flatten().map(|mode| mode.amplitude.symbol()).collect();
    let written = |name: &Symbol| match amplitudes.contains(name) {
        true => format!("`{}`, the amplitude", name.written()),
        false => format!("`{}`", name.written()),
    };
    let names: Vec<String> = missing.iter().map(written).collect();
    format!("note: not judged, values are needed for: {}", names.join(", "))
}

/// The number of harmonics of a balance without a choice.
const USUAL_HARMONICS: u32 = 2;

/// The modes of coupled equations, with the values that are left once those that the equations need
/// stand in them.
pub(super) struct Derived {
    pub modes: NormalModes,
    pub values: Option<Values>,
    /// The letters of the answer.
    pub letters: ResultSymbols,
}

/// Derives the modes of coupled equations, one of them where a number is given.
///
/// # Errors
/// Options that are those of one coordinate; equations that have no modes in formulas.
pub(super) fn derived(
    question: &EquationArguments,
    mode: Option<u32>,
    steps: bool,
    equations: CoupledEquations,
    problem: &Problem,
) -> Result<Derived, Failure> {
    for (key, given) in [("small", problem.small.is_some()), ("about", problem.about.is_some())] {
        if given {
            return Err(Failure::because(format!(
                "`{key}` is of one coordinate: modes are expanded in their amplitude about the place of rest"
            )));
        }
    }
    let method = question.method.as_deref().or(problem.method.as_deref());
    let is_pade = method == Some(Method::Pade.name());
    let is_balance = method == Some(Method::HarmonicBalance.name());
    let is_series = method.is_none_or(|name| name == Method::LindstedtPoincare.name());
    if let Some(name) = method.filter(|_| !(is_pade || is_balance || is_series)) {
        return Err(Failure::Usage(format!(
            "--method {name}: the modes of coupled equations are derived by {}, with an approximant on top by {}, with a number of harmonics by {}; their slow equations by {} or {}",
            Method::LindstedtPoincare.name(),
            Method::Pade.name(),
            Method::HarmonicBalance.name(),
            Method::MultipleScales.name(),
            Method::Averaging.name()
        )));
    }
    let order = question.order.or(problem.order);
    let (order, pade) = match (order, is_pade) {
        (None, false) => (None, None),
        (Some(Order::Power(order)), false) => (Some(order), None),
        (None, true) => (None, Some((2, 1))),
        (Some(Order::Degrees(Degrees::Quotient(above, below))), true) => {
            (None, Some((above, below)))
        }
        (Some(_), true) => {
            return Err(Failure::Usage(
                "--order: an approximant has two degrees, those of numerator and denominator: --order 2,1".to_owned(),
            ));
        }
        (Some(_), false) => {
            return Err(Failure::Usage(
                "--order: the order of modes is the highest power of the amplitude in omega^2, or the number of harmonics; degrees are those of --method pade"
                    .to_owned(),
            ));
        }
    };
    let text = problem.equation.as_deref();
    let refused = |error: ModeError| refused(&error, text);
    let system = free_system(equations, problem)?;
    let amplitude = amplitude(question, problem.amplitude.as_deref())?;
    if is_balance {
        let name = Method::HarmonicBalance.name();
        if amplitude == Some(AmplitudeConvention::FirstHarmonic) {
            return Err(Failure::Usage(format!(
                "--amplitude: in a balance of harmonics the amplitude is the start of the first coordinate, {}",
                AmplitudeConvention::Initial.name()
            )));
        }
        if steps {
            return Err(Failure::Usage(format!(
                "--steps: --method {name} has no orders, its equations are in the answer"
            )));
        }
    }
    let options = ModeOptions {
        mode: mode.map(|mode| mode as usize),
        order,
        pade,
        harmonics: is_balance.then(|| order.unwrap_or(USUAL_HARMONICS)),
        amplitude: amplitude.unwrap_or(AmplitudeConvention::FirstHarmonic),
        steps,
        supervision: session::supervision(),
    };
    let letters = system.letters;
    let _letters = letters.in_force();
    let values = exact_values(&question.at, problem.values_of_motion())?;
    let values = values.map(|values| as_meant(&values, |name| system.resolve(name))).transpose()?;
    let (modes, values) = with_progress("of the calculation", || {
        with_numbers(&system, &options, values).map_err(refused)
    })?;
    if let Some(error) = no_formula(&modes) {
        return Err(refused(error));
    }
    Ok(Derived { modes, values, letters })
}

/// The system of a problem, about its place of rest.
///
/// # Errors
/// Equations that are not of such a system.
pub(super) fn free_system(
    equations: CoupledEquations,
    problem: &Problem,
) -> Result<FreeSystem, Failure> {
    let mechanism = problem
        .coupled_equations(ReadingCommand::Derive)
        .map_err(|error| Failure::refused(&error, error.help()))?;
    let system = match mechanism {
        Some(mechanism) => FreeSystem::of_mechanism(&mechanism),
        None => FreeSystem::new(equations),
    };
    system.map_err(|error| refused(&error, problem.equation.as_deref()))
}

/// The modes; where letters leave no closed form, or one without a value, and values are given, those
/// of the equations with the numbers in them, and the values that are left.
fn with_numbers(
    system: &FreeSystem,
    options: &ModeOptions,
    values: Option<Values>,
) -> Result<(NormalModes, Option<Values>), ModeError> {
    match (derive(system, options), values) {
        (Err(ModeError::Letters { .. }), Some(values)) => {
            let (known, rest) = values.split(&system.equations.parameters);
            let with_values = system.with_values(&known)?;
            Ok((derive(&with_values, options)?, Some(rest)))
        }
        (Ok(found), Some(values)) if lacks_value(&found, &values) => {
            let (known, rest) = values.split(&system.equations.parameters);
            let in_numbers = system.with_values(&known).and_then(|own| derive(&own, options));
            match in_numbers {
                Ok(modes) if modes.modes.iter().any(Result::is_ok) => Ok((modes, Some(rest))),
                _ => Ok((found, Some(values))),
            }
        }
        (found, values) => Ok((found?, values)),
    }
}

/// Whether a name in the formula of a mode has no real value at the values, or that of zero, as the
/// frequency of another mode that does not swing.
fn lacks_value(modes: &NormalModes, values: &Values) -> bool {
    let is_given = |name: &Symbol| values.get(*name).is_some();
    let value_of = |name: Symbol| match name == Symbol::new("pi") {
        true => Some(std::f64::consts::PI),
        false => values.get(name),
    };
    let lacks = |mode: &NonlinearMode| {
        let defined = defined_values(&mode.definitions, &value_of);
        defined.map_or(true, |defined| {
            defined.into_iter().any(|(_, value)| !value.is_finite() || value == 0.0)
        })
    };
    modes.system.equations.parameters.iter().all(is_given)
        && modes.modes.iter().flatten().any(lacks)
}

/// The reason why the first mode has no formula, if none has one.
fn no_formula(modes: &NormalModes) -> Option<ModeError> {
    let mut reasons = modes.modes.iter().map(|mode| mode.as_ref().err().cloned());
    let first = reasons.next().flatten()?;
    reasons.all(|reason| reason.is_some()).then_some(first)
}

/// The verdict on each mode that has a formula; `None` for the others. A mode whose true motion was not
/// found is said.
///
/// # Errors
/// Missing or unknown values.
fn judged(
    modes: &NormalModes,
    at: &Values,
    tolerance: f64,
) -> Result<Vec<Result<JudgedMode, String>>, VerificationError> {
    let interrupt = session::supervision().interrupt;
    let mut all = Vec::new();
    for mode in modes.modes.iter().flatten() {
        match judge_mode(&modes.system, mode, at, tolerance, interrupt) {
            Ok(judged) => all.push(Ok(judged)),
            Err(
                error @ (VerificationError::NoMode { .. }
                | VerificationError::Interrupted
                | VerificationError::NoBalance { .. }
                | VerificationError::VanishingDivisor { .. }
                | VerificationError::NoValue { .. }),
            ) => all.push(Err(error.to_string())),
            Err(error) => return Err(error),
        }
    }
    Ok(all)
}

/// A refusal, with the term that it names shown in the equations.
pub(super) fn refused(error: &ModeError, text: Option<&str>) -> Failure {
    let term = error.term();
    let shown = term.zip(text).and_then(|(term, text)| located(term, text));
    let shown = shown.map_or(String::new(), |[line, carets]| format!("\n  {line}\n  {carets}"));
    Failure::refused(&format!("{error}{shown}"), error.help())
        .of_kind(error)
        .naming(term.map(ToString::to_string).as_deref())
}

/// The place of a term in the equations as they were typed, or of the first derivative in it.
pub(super) fn located(term: &Expr, text: &str) -> Option<[String; 2]> {
    let derivatives = term.symbols().into_iter().filter(|name| name.primes() > 0);
    let mut names =
        std::iter::once(term.to_string()).chain(derivatives.map(|name| name.to_string()));
    names.find_map(|name| excerpt_of(text, &name))
}

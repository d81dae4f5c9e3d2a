//! `lindstedt derive` of coupled equations that are damped, driven or in resonance: slow equations.

use crate::coupled::CoupledEquations;
use crate::export::{json, slow_equations as drawing};
use crate::modes::{FreeSystem, ModeError};
use crate::multiple_scales::{
    CoupledSystem, MultipleScalesError, MultipleScalesOptions, SlowMotion, derive,
};
use crate::problem::{Order, Problem, ReadingCommand};
use crate::report::{self, SlowReport};
use crate::solution::Method;
use crate::values::Values;
use crate::verify::{Verdict, VerificationError, judge_slow_motion};

use super::answer::{Answer, no_such};
use super::derive::{DeriveArguments, as_meant, exact_values, unjudged};
use super::modes::located;
use super::problem::value_name;
use super::progress::with_progress;
use super::{Failure, Format, Outcome, files, json_text, session, tolerance};

/// Whether slow equations are asked for: by name, or because something drives or damps the equations
/// and no method is named.
pub(super) fn is_asked(
    arguments: &DeriveArguments,
    equations: &CoupledEquations,
    problem: &Problem,
) -> bool {
    let method = arguments.question.method.as_deref().or(problem.method.as_deref());
    match method {
        Some(name) => [Method::MultipleScales, Method::Averaging].map(Method::name).contains(&name),
        None => matches!(
            FreeSystem::new(equations.clone()),
            Err(ModeError::Driven(_) | ModeError::Damped(_))
        ),
    }
}

/// Derives the slow equations, and judges them where values are given.
///
/// # Errors
/// Options of other methods; equations that have no slow equations.
pub(super) fn run(
    arguments: &DeriveArguments,
    equations: CoupledEquations,
    problem: &Problem,
) -> Result<Outcome, Failure> {
    let question = &arguments.question;
    if let Some(option) = question.of_one_coordinate() {
        return Err(Failure::Usage(format!(
            "{option}: it is of one coordinate; slow equations of coupled ones take --order, --small, --resonance and --at"
        )));
    }
    for (option, given) in
        [("--mode", arguments.mode.is_some()), ("--amplitude", question.amplitude.is_some())]
    {
        if given {
            return Err(Failure::Usage(format!(
                "{option} says nothing to the slow equations of coupled oscillators, which are of all modes together"
            )));
        }
    }
    let order = match question.order.or(problem.order) {
        None => None,
        Some(Order::Power(order)) => Some(order as usize),
        Some(Order::Degrees(_)) => {
            return Err(Failure::Usage("--order: a single number is expected".to_owned()));
        }
    };
    let method = question.method.as_deref().or(problem.method.as_deref());
    let averaging = method == Some(Method::Averaging.name());
    if averaging && order.is_some() {
        return Err(Failure::Usage(
            "--order: averaging of coupled equations is of the first order; --method multiple-scales has others"
                .to_owned(),
        ));
    }
    let text = problem.equation.as_deref();
    let refused = |error: MultipleScalesError| refused(&error, text);
    let small = question.small.as_deref().or(problem.small.as_deref()).map(value_name);
    let mechanism = problem
        .coupled_equations(ReadingCommand::Derive)
        .map_err(|error| Failure::refused(&error, error.help()))?;
    let system = match mechanism {
        Some(mechanism) => CoupledSystem::of_mechanism(&mechanism, small),
        None => CoupledSystem::new(equations, small),
    };
    let system = system.map_err(refused)?;
    let values = exact_values(&question.at, problem.values_of_motion())?;
    let values = values.map(|values| as_meant(&values, |name| system.resolve(name))).transpose()?;
    let options = MultipleScalesOptions {
        order,
        averaging,
        steps: arguments.steps,
        resonance: question.resonance.clone().or_else(|| problem.resonance.clone()),
        values: values.as_ref().map(Values::numbers).unwrap_or_default(),
        supervision: session::supervision(),
    };
    let (slow, values) = with_progress("of the calculation", || {
        with_numbers(&system, &options, values).map_err(refused)
    })?;
    // Of numbers alone there is nothing left to give.
    let asked = values.is_some()
        || arguments.common.draws()
        || arguments.common.tolerance.is_some()
        || slow.system.equations.parameters.is_empty();
    let mut lost = None;
    let judged = match asked {
        true => {
            let values = values.unwrap_or_default();
            let interrupt = session::supervision().interrupt;
            let tolerance = tolerance(&arguments.common);
            match judge_slow_motion(&slow, &values, tolerance, interrupt) {
                Ok(judged) => Some(judged),
                // The formulas are an answer without their verdict.
                Err(VerificationError::NoSystem(reason)) => {
                    lost = Some(format!("warning: no verdict: {reason}"));
                    None
                }
                Err(error) => return Err(unjudged(&error)),
            }
        }
        false => None,
    };
    let report = SlowReport { slow: &slow, judged: judged.as_ref() };
    let document =
        report::slow_equations(&report).map_err(|error| Failure::because(error.to_string()))?;
    let answer = Answer {
        document: &document,
        width: files::width(arguments.common.output.as_deref()),
        picture: Some(&|| match judged.as_ref().is_some_and(|judged| judged.transient.is_some()) {
            true => Ok(drawing::picture(&report)?),
            false => Err(Failure::because(format!(
                "it is of the motion from given amplitudes, --at {}",
                slow.amplitudes
                    .iter()
                    .map(|name| format!("{name}=0.1"))
                    .collect::<Vec<_>>()
                    .join(",")
            ))),
        }),
        other: &|format| {
            match format {
            Format::Json => {
                let document = json::slow_equations(&report);
                json_text(&document.map_err(|error| Failure::because(error.to_string()))?)
            }
            Format::Code(_) => Err(Failure::Usage(
                "there is no program of the slow equations of coupled oscillators: --format json has their formulas"
                    .to_owned(),
            )),
            format => no_such(format),
        }
        },
    };
    let stopped = asked && session::supervision().interrupt.is_requested();
    let early = || "warning: stopped early, what there is is kept".to_owned();
    Ok(Outcome {
        verdict: match lost {
            Some(_) => Some(Verdict::Fail),
            None => judged.as_ref().and_then(|judged| judged.verdict),
        },
        note: lost.or_else(|| stopped.then(early)),
        partial: stopped,
        ..answer.outcome(&arguments.common)?
    })
}

/// The slow equations; where letters leave no closed form and values are given, those of the equations with the numbers in them, and the values that are left.
fn with_numbers(
    system: &CoupledSystem,
    options: &MultipleScalesOptions,
    values: Option<Values>,
) -> Result<(SlowMotion, Option<Values>), MultipleScalesError> {
    let in_the_way = |error: &MultipleScalesError| {
        matches!(error, MultipleScalesError::Modes(ModeError::Letters { .. }))
    };
    match (derive(system, options), values) {
        (Err(error), Some(values)) if in_the_way(&error) => {
            let (known, rest) = values.split(&system.equations.parameters);
            Ok((derive(&system.with_values(&known)?, options)?, Some(rest)))
        }
        (found, values) => Ok((found?, values)),
    }
}

/// A refusal, with the term that it names shown in the equations.
fn refused(error: &MultipleScalesError, text: Option<&str>) -> Failure {
    let term = error.term();
    let shown = term.zip(text).and_then(|(term, text)| located(term, text));
    let shown = shown.map_or(String::new(), |[line, carets]| format!("\n  {line}\n  {carets}"));
    Failure::refused(&format!("{error}{shown}"), error.help())
        .of_kind(error)
        .naming(term.map(ToString::to_string).as_deref())
}

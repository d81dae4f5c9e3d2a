//! `lindstedt derive --method harmonic-balance` of coupled equations: modes with one harmonic.

use crate::coupled::CoupledEquations;
use crate::export::json;
use crate::modes::one_harmonic_modes;
use crate::problem::Problem;
use crate::report::{self, OneHarmonicReport};
use crate::solution::{AmplitudeConvention, Method};
use crate::verify::judge_one_harmonic;

use super::answer::{Answer, no_such};
use super::derive::{DeriveArguments, amplitude, as_meant, exact_values, unjudged};
use super::modes::{free_system, refused};
use super::{Failure, Format, Outcome, files, json_text, tolerance};

/// Derives the modes with one harmonic, and judges them where values are given.
///
/// # Errors
/// Options of other methods; equations that have no such modes in closed form.
pub(super) fn run(
    arguments: &DeriveArguments,
    equations: CoupledEquations,
    problem: &Problem,
) -> Result<Outcome, Failure> {
    let question = &arguments.question;
    let usage = |text: String| Err(Failure::Usage(text));
    let name = Method::HarmonicBalance.name();
    if arguments.mode.is_some() {
        return usage(format!(
            "--mode says nothing to --method {name}, whose families may have several modes"
        ));
    }
    if arguments.steps {
        return usage(
            "--steps: one harmonic has no orders, its equations are in the answer".to_owned(),
        );
    }
    let convention = amplitude(question, problem.amplitude.as_deref())?;
    if convention == Some(AmplitudeConvention::FirstHarmonic) {
        return usage(format!(
            "--amplitude: with one harmonic the amplitude is that of the first coordinate, {}",
            AmplitudeConvention::Initial.name()
        ));
    }
    let system = free_system(equations, problem)?;
    let letters = system.letters;
    let _letters = letters.in_force();
    let modes = one_harmonic_modes(&system)
        .map_err(|error| refused(&error, problem.equation.as_deref()))?;
    let values = exact_values(&question.at, problem.values_of_motion())?;
    let values = values.map(|values| as_meant(&values, |name| system.resolve(name))).transpose()?;
    let asked = values.is_some() || arguments.common.tolerance.is_some();
    let judged = match asked {
        true => {
            let values = values.unwrap_or_default();
            let judged = judge_one_harmonic(&modes, &values, tolerance(&arguments.common));
            Some(judged.map_err(|error| unjudged(&error))?)
        }
        false => None,
    };
    let report = OneHarmonicReport { modes: &modes, judged: judged.as_ref() };
    let answer = Answer {
        document: &report::one_harmonic(&report),
        width: files::width(arguments.common.output.as_deref()),
        picture: Some(&|| {
            Err(Failure::because(
                "closed forms with one harmonic have no picture: --order 2 draws the modes with two harmonics"
                    .to_owned(),
            ))
        }),
        other: &|format| {
            match format {
            Format::Json => json_text(&json::one_harmonic(&report)),
            Format::Code(_) => Err(Failure::Usage(
                "closed forms with one harmonic have no program: --order 2 has one with the numbers of two harmonics, --format json has the formulas"
                    .to_owned(),
            )),
            format => no_such(format),
        }
        },
    };
    Ok(Outcome {
        verdict: judged.as_ref().map(|judged| judged.verdict),
        ..answer.outcome(&arguments.common)?
    })
}

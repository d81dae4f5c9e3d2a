//! `lindstedt stability PROBLEM`.

use std::path::Path;

use crate::export::{json, stability};
use crate::hill::{self, Chart, HillError, HillOptions, JudgedCurve, TransitionCurves};
use crate::problem::{Order, ReadingCommand};
use crate::report::{self, StabilityReport};
use crate::verify::Verdict;
use crate::{Symbol, Values};
use clap::Args;

use super::answer::{Answer, Draw, no_such};
use super::derive::{exact_values, formula, oscillator};
use super::files::width;
use super::problem::problem;
use super::{Common, Failure, Format, Outcome, Work, json_text, tolerance};

/// Transition curves of a linear equation with periodic coefficients, such as Mathieu's: where rest
/// is stable
#[derive(Args)]
pub struct StabilityArguments {
    /// An equation in quotes, a TOML file, a name of the catalogue, or - for standard input
    pub problem: String,
    /// Highest power of the small parameters, all together, that is kept; 6 without it
    #[arg(long, value_parser = super::count, allow_hyphen_values = true)]
    order: Option<u32>,
    /// The tongues 0 to N; 3 without it
    #[arg(long, value_name = "N", value_parser = super::count, allow_hyphen_values = true)]
    tongues: Option<u32>,
    /// What the curves give: a letter of the mean stiffness, or the frequency
    #[arg(long = "for", value_name = "NAME")]
    solve_for: Option<String>,
    /// A small parameter (repeatable); without it eps, and letters that alone stand before a wave
    /// or the velocity
    #[arg(long, value_name = "NAME")]
    small: Vec<String>,
    /// A value, exact (1.5, 3/2, pi/3): asks for numbers and verdicts, and is how far a picture or
    /// a table goes; repeatable
    #[arg(long, value_name = "NAME=VALUE,...")]
    at: Vec<String>,
    #[command(flatten)]
    pub common: Common,
}

/// Points of a curve of a chart.
const STEPS: u32 = 60;

impl Work for StabilityArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn input(&self) -> Option<&Path> {
        super::problem::path(&self.problem)
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &StabilityArguments) -> Result<Outcome, Failure> {
    let problem = problem(&arguments.problem)?;
    let formula = formula(&problem, ReadingCommand::Stability)?;
    let oscillator = oscillator(&formula, None)?;
    let usual = HillOptions::default();
    let order = match formula.order {
        None => None,
        Some(Order::Power(order)) => Some(order),
        Some(Order::Degrees(_)) => {
            return Err(Failure::because(
                "`order` of a transition curve is a whole number: degrees L,M are those of pade"
                    .to_owned(),
            ));
        }
    };
    let options = HillOptions {
        order: arguments.order.or(order).unwrap_or(usual.order),
        tongues: arguments.tongues.map_or(usual.tongues, |tongues| tongues as usize),
        small: match arguments.small.is_empty() {
            true => formula.small.map(str::to_owned).into_iter().collect(),
            false => arguments.small.clone(),
        },
        solve_for: arguments.solve_for.clone(),
    };
    let curves = hill::transition_curves(&oscillator, &options)
        .map_err(|error| refused(&oscillator.typed, &error))?;
    let values = exact_values(&arguments.at, problem.values_of_motion())?;
    let asked = values.is_some() || arguments.common.tolerance.is_some();
    let values = values.unwrap_or_default();
    let tolerance = tolerance(&arguments.common);
    let judged: Option<Vec<JudgedCurve>> = match asked {
        false => None,
        true => Some(hill::judge(&curves, &values, tolerance).map_err(|error| unjudged(&error))?),
    };
    let report = StabilityReport {
        curves: &curves,
        judged: judged.as_deref().map(|judged| (&values, judged)),
        tolerance,
    };
    let charted = arguments.common.draws() || arguments.common.format() == Format::Csv;
    let charts = match charted {
        // A page has the curves where it is known how far they go.
        false if arguments.common.format() == Format::Html => charts(&curves, &values).ok(),
        false => None,
        true => Some(charts(&curves, &values)?),
    };
    let drawn = charts.as_ref().map(|(by, charts)| || picture(&curves, *by, charts, &values));
    let answer = Answer {
        document: &report::stability(&report),
        width: width(arguments.common.output.as_deref()),
        picture: drawn.as_ref().map(|draw| draw as Draw),
        other: &|format| match (format, &charts) {
            (Format::Json, _) => json_text(&json::stability(&report)),
            (Format::Csv, Some((by, charts))) => Ok(stability::csv(&curves, *by, charts)),
            (format, _) => no_such(format),
        },
    };
    Ok(Outcome {
        verdict: report.passes().map(Verdict::from_passed),
        ..answer.outcome(&arguments.common)?
    })
}

/// A refusal, with the term that it names shown in the equation.
fn refused(typed: &crate::expr::Typed, error: &HillError) -> Failure {
    let place = error.term().and_then(|term| typed.locate(term));
    let shown = place.map_or(String::new(), |[line, carets]| format!("\n  {line}\n  {carets}"));
    Failure::refused(&format!("{error}{shown}"), error.help()).of_kind(error).naming(error.term())
}

fn unjudged(error: &HillError) -> Failure {
    match error {
        HillError::Unknown(..) => Failure::Usage(format!("--at: {error}")),
        _ => Failure::refused(error, error.help()),
    }
}

/// The curves from nothing small up to the value of the first small parameter that has one.
fn charts(curves: &TransitionCurves, values: &Values) -> Result<(Symbol, Vec<Chart>), Failure> {
    let sizes = curves.small.iter().filter_map(|name| Some((*name, values.get(*name)?)));
    let eps = Symbol::new("eps");
    let Some((by, upto)) = sizes.max_by_key(|(name, _)| *name == eps) else {
        return Err(Failure::because(format!(
            "a picture or a table of the curves needs to know how far it goes\n  help: --at {}=1",
            curves.small.first().map_or("eps", |name| name.name())
        )));
    };
    let charts = hill::chart(curves, &values.numbers(), by, upto, STEPS)
        .map_err(|error| unjudged(&error))?;
    Ok((by, charts))
}

fn picture(
    curves: &TransitionCurves,
    by: Symbol,
    charts: &[Chart],
    values: &Values,
) -> Result<String, Failure> {
    let others = values.iter().filter(|(name, _)| *name != by);
    let others: Vec<String> = others.map(|(name, value)| format!("; {name} = {value}")).collect();
    let caption = format!("{}{}", curves.equation, others.concat());
    Ok(stability::picture(curves, by, charts, &caption)?)
}

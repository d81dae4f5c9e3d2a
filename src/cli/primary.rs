//! `lindstedt simulate FILE` of a file with a main mass, `[primary]`.

use lindstedt::Interrupt;
use lindstedt::export::{json, primary};
use lindstedt::impact::Units;
use lindstedt::impact::primary::{PrimaryRow, PrimarySettings, PrimaryStop, simulate_primary, sweep_primary};
use lindstedt::impact::sweep::Axis;
use lindstedt::problem::Problem;
use lindstedt::report::{self, PrimaryReport, TRUSTED};
use lindstedt::verify::Verdict;

use super::answer::{Answer, no_such};
use super::files::width;
use super::progress;
use super::{Common, Failure, Format, Outcome, STOP, json_text};

/// What is asked of a main mass.
pub(super) struct Asked<'a> {
    /// Times at which the states are wanted.
    pub samples: &'a [f64],
    /// The frequencies of the force, in rad/s.
    pub sweep: &'a [Axis],
    pub common: &'a Common,
}

pub(super) fn run(problem: &Problem, asked: &Asked) -> Result<Outcome, Failure> {
    if asked.common.format() == Format::Latex {
        return Err(Failure::Usage(
            "a simulation has no LaTeX form, for it has no formulas: choose --format text, json or csv".to_owned(),
        ));
    }
    match asked.sweep {
        [] => one(problem, asked),
        [axis] if axis.name() == "frequency" => many(problem, asked, axis),
        [_, _, ..] => Err(Failure::Usage(
            "a main mass is swept over the frequency of its force alone: give one --sweep, frequency=5:20:61, in rad/s"
                .to_owned(),
        )),
        [axis, ..] => Err(Failure::Usage(format!(
            "a main mass is swept over the frequency of its force alone, not over `{}`: --sweep frequency=5:20:61, in rad/s",
            axis.name()
        ))),
    }
}

fn one(problem: &Problem, asked: &Asked) -> Result<Outcome, Failure> {
    let (common, file) = (asked.common, problem.primary_case(false));
    let file = file.map_err(|error| Failure::refused(&error, error.help()))?;
    let settings = PrimarySettings {
        interrupt: Interrupt::by(&STOP),
        ..file.settings
    };
    if let Some(late) = asked.samples.iter().find(|sample| **sample > settings.duration) {
        return Err(Failure::Refused(format!(
            "--sample {late} lies beyond the duration {}\n  help: raise `duration` in [run]",
            settings.duration
        )));
    }
    let motion = simulate_primary(file.case, &settings).map_err(|error| Failure::refused(&error, None))?;
    let report = PrimaryReport {
        motion: &motion,
        units: &file.units,
        samples: asked.samples,
    };
    let answer = Answer {
        document: &report::primary(&report),
        width: width(common.output.as_deref()),
        picture: Some(&|| picture(&report)),
        other: &|format| match format {
            Format::Csv => Ok(primary::csv(&report)),
            Format::Json => json_text(&json::primary(&report)),
            format => no_such(format),
        },
    };
    let kept = motion.energy.residual <= common.tolerance.unwrap_or(TRUSTED);
    Ok(Outcome {
        note: match report.doubt() {
            _ if !motion.is_complete() => Some(format!(
                "warning: stopped early, what there is is kept: {}",
                motion.stop
            )),
            doubt => doubt.map(|doubt| format!("warning: {doubt}")),
        },
        verdict: Some(Verdict::of(kept && motion.is_complete())),
        partial: !report.is_complete(),
        ..answer.outcome(common)?
    })
}

fn many(problem: &Problem, asked: &Asked, axis: &Axis) -> Result<Outcome, Failure> {
    if !asked.samples.is_empty() {
        return Err(Failure::Usage(
            "a sweep reports one line a motion: leave out --sample".to_owned(),
        ));
    }
    let common = asked.common;
    let file = problem
        .primary_case(true)
        .map_err(|error| Failure::refused(&error, error.help()))?;
    let frequencies: Vec<f64> = axis.values().iter().map(|value| value * file.units.time()).collect();
    let settings = PrimarySettings {
        interrupt: Interrupt::by(&STOP),
        ..file.settings
    };
    let bar = progress::bar(frequencies.len(), "{bar:40} {pos}/{len} frequencies, {eta} left");
    let progress = |done: usize| bar.inc(done as u64);
    let rows =
        sweep_primary(file.case, &frequencies, &settings, progress).map_err(|error| Failure::refused(&error, None))?;
    bar.finish_and_clear();
    let answer = Answer {
        document: &report::primary_sweep(&rows, &file.units),
        width: width(common.output.as_deref()),
        picture: Some(&|| sweep_picture(&rows, &file.units)),
        other: &|format| match format {
            Format::Csv => Ok(primary::sweep_csv(&rows)),
            Format::Json => json_text(&json::primary_sweep(&rows, &file.units)),
            format => no_such(format),
        },
    };
    let broken = rows.iter().filter(|row| row.stop != PrimaryStop::Duration).count();
    Ok(Outcome {
        note: (broken > 0).then(|| format!("warning: {broken} of {} motions stopped early", rows.len())),
        verdict: Some(Verdict::of(broken == 0)),
        partial: broken > 0,
        ..answer.outcome(common)?
    })
}

#[cfg(not(feature = "plot"))]
fn picture(_: &PrimaryReport) -> Result<String, Failure> {
    super::no_pictures()
}

#[cfg(not(feature = "plot"))]
fn sweep_picture(_: &[PrimaryRow], _: &Units) -> Result<String, Failure> {
    super::no_pictures()
}

#[cfg(feature = "plot")]
fn picture(report: &PrimaryReport) -> Result<String, Failure> {
    primary::picture(report).map_err(|error| Failure::refused(&error, None))
}

#[cfg(feature = "plot")]
fn sweep_picture(rows: &[PrimaryRow], units: &Units) -> Result<String, Failure> {
    primary::sweep_picture(rows, units).map_err(|error| Failure::refused(&error, None))
}

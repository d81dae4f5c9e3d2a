//! `lindstedt simulate FILE` of a file with a main mass, `[primary]`.

use crate::export::json::points::PrimaryPoint;
use crate::export::json::shard::Shard;
use crate::export::{json, primary};
use crate::impact::primary::{
    PrimaryCase, PrimaryError, PrimaryMotion, PrimaryParameter, PrimaryRow, PrimarySettings,
    PrimaryStop, nearby_rest_times, simulate_primary, sweep_primary,
};
use crate::impact::sweep::{Axis, grid_size, grid_values};
use crate::problem::Problem;
use crate::report::{self, PrimaryReport, PrimarySweepReport, TRUSTED};
use crate::verify::Verdict;

use super::answer::{Answer, Draw, no_such};
use super::files::width;
use super::progress::{MOTIONS, PartsBar};
use super::session;
use super::shard::{self, Points};
use super::simulate::{
    CHAIN_TOLERANCE, SimulateArguments, TOGETHER, check_format, check_samples, check_varied, inputs,
};
use super::{Failure, Format, Outcome, json_text};

pub(super) fn run(problem: &Problem, asked: &SimulateArguments) -> Result<Outcome, Failure> {
    check_format(&asked.common)?;
    match asked.sweep.as_slice() {
        [] => run_single(problem, asked),
        axes => run_sweep(problem, asked, axes),
    }
}

fn run_single(problem: &Problem, asked: &SimulateArguments) -> Result<Outcome, Failure> {
    let (common, file) = (&asked.common, problem.primary_case(&[]));
    let file = file.map_err(|error| Failure::refused(&error, error.help()))?;
    let settings = settings(asked, file.settings);
    check_samples(&asked.sample, settings.duration, "`duration` in [run]")?;
    let motion = simulate_primary(file.case, &settings)?;
    let judge = match asked.chain {
        true => Some(simulate_primary(file.case, &PrimarySettings { chain: false, ..settings })?),
        false => None,
    };
    let is_free = file.case.primary.force == 0.0;
    let nearby = match asked.chain && is_free {
        true => nearby_rest_times(file.case, &settings)?,
        false => None,
    };
    let report = PrimaryReport {
        motion: &motion,
        units: &file.units,
        samples: &asked.sample,
        judge: judge.as_ref(),
        nearby,
    };
    let answer = Answer {
        document: &report::primary(&report),
        width: width(common.output.as_deref()),
        picture: Some(&|| Ok(primary::picture(&report)?)),
        other: &|format| match format {
            Format::Csv => Ok(primary::csv(&report)),
            Format::Json => json_text(&json::primary(&report)),
            format => no_such(format),
        },
    };
    let kept = match &judge {
        Some(judge) => is_near(&motion, judge, common.tolerance.unwrap_or(CHAIN_TOLERANCE)),
        None => motion.energy.residual <= common.tolerance.unwrap_or(TRUSTED),
    };
    Ok(Outcome {
        note: match report.doubt() {
            _ if !motion.is_complete() => {
                Some(format!("warning: stopped early, what there is is kept: {}", motion.stop))
            }
            doubt => doubt.map(|doubt| format!("warning: {doubt}")),
        },
        verdict: Some(Verdict::from_passed(kept && motion.is_complete())),
        partial: !report.is_complete(),
        ..answer.outcome(common)?
    })
}

/// The settings of the file, by closed forms where they are asked for.
fn settings(asked: &SimulateArguments, settings: PrimarySettings) -> PrimarySettings {
    PrimarySettings { chain: asked.chain, interrupt: session::interrupt(), ..settings }
}

/// Whether a chain ends as its integration does: with the same rest time, or where there is none
/// with the same amplitude in the long run.
fn is_near(motion: &PrimaryMotion, judge: &PrimaryMotion, allowed: f64) -> bool {
    let driven = motion.case.primary.force != 0.0;
    let [found, truth] = match (driven, motion.rest_time(), judge.rest_time()) {
        (false, Ok(found), Ok(truth)) => [found, truth],
        (false, Ok(_), Err(_)) | (false, Err(_), Ok(_)) => return false,
        _ => [motion, judge].map(|motion| motion.largest_since(0.75 * motion.end)),
    };
    judge.is_complete() && (found - truth).abs() <= allowed * truth.abs()
}

fn run_sweep(
    problem: &Problem,
    asked: &SimulateArguments,
    axes: &[Axis],
) -> Result<Outcome, Failure> {
    let common = &asked.common;
    check_sweep(asked)?;
    let parameters: Vec<PrimaryParameter> = axes
        .iter()
        .map(|axis| axis.name().parse())
        .collect::<Result<_, PrimaryError>>()
        .map_err(|error| Failure::refused(&error, error.help()))?;
    if let Some(index) =
        (1..parameters.len()).find(|index| parameters[..*index].contains(&parameters[*index]))
    {
        return Err(Failure::Usage(format!("`{}` is swept twice", parameters[index].name())));
    }
    let total = grid_size(axes)?;
    let (mut motions, mut units) = (Vec::with_capacity(total), Vec::with_capacity(total));
    for number in 0..total {
        let varied: Vec<(PrimaryParameter, f64)> =
            parameters.iter().copied().zip(grid_values(axes, number)).collect();
        let file = problem.primary_case(&varied);
        let file = file.map_err(|error| Failure::refused(&error, error.help()))?;
        motions.push((file.case, settings(asked, file.settings)));
        units.push(file.units);
    }
    if let Some(shard) = asked.shard.shard {
        return write_shard(shard, asked, &motions);
    }
    let rows = match shard::known::<PrimaryPoint>(total)? {
        Some(rows) => {
            let read = |(index, (row, (case, _))): (usize, (&PrimaryPoint, &Followed))| {
                row.read(case).ok_or_else(|| shard::unreadable(index))
            };
            rows.iter().zip(&motions).enumerate().map(read).collect::<Result<_, _>>()?
        }
        None => {
            let bar = PartsBar::new(total, MOTIONS);
            let rows =
                sweep_primary(&motions, |done| bar.advance(done)).map_err(|(number, error)| {
                    Failure::because(format!("motion {}: {error}", number + 1))
                })?;
            bar.finish();
            rows
        }
    };
    let report = PrimarySweepReport { axes, parameters: &parameters, rows: &rows, units: &units };
    let draw: Draw = &|| Ok(primary::sweep_picture(&report)?);
    let answer = Answer {
        document: &report::primary_sweep(&report),
        width: width(common.output.as_deref()),
        picture: (axes.len() == 1).then_some(draw),
        other: &|format| match format {
            Format::Csv => Ok(primary::sweep_csv(&report)),
            Format::Json => json_text(&json::primary_sweep(&report)),
            format => no_such(format),
        },
    };
    let broken = rows.iter().filter(|row| row.stop != PrimaryStop::Duration).count();
    Ok(Outcome {
        note: (broken > 0)
            .then(|| format!("warning: {broken} of {} motions stopped early", rows.len())),
        verdict: Some(Verdict::from_passed(broken == 0)),
        partial: broken > 0,
        ..answer.outcome(common)?
    })
}

/// Refuses what a sweep leaves no place for.
fn check_sweep(asked: &SimulateArguments) -> Result<(), Failure> {
    if !asked.sample.is_empty() {
        return Err(Failure::Usage(
            "a sweep reports one line a motion: leave out --sample".to_owned(),
        ));
    }
    if asked.sweep.len() > 1 && asked.common.draws() {
        return Err(Failure::Usage(
            "--plot draws curves over one parameter of a main mass, but more are swept: leave out --plot, or give the others in the \
             file"
                .to_owned(),
        ));
    }
    check_varied(&asked.sweep)
}

/// A motion and how it is followed.
type Followed = (PrimaryCase, PrimarySettings);

/// The lines of the motions of a shard.
fn write_shard(
    shard: Shard,
    asked: &SimulateArguments,
    motions: &[Followed],
) -> Result<Outcome, Failure> {
    let points = Points {
        total: motions.len(),
        together: TOGETHER,
        bar: MOTIONS,
        inputs: &|index| inputs(&asked.sweep, index),
    };
    shard::write(shard, &asked.common, &points, |indices| {
        let own: Vec<Followed> = indices.iter().map(|index| motions[*index]).collect();
        let rows = sweep_primary(&own, |_| ()).map_err(|(number, error)| {
            Failure::because(format!("motion {}: {error}", indices[number] + 1))
        })?;
        let is_whole = |row: &&PrimaryRow| row.stop != PrimaryStop::Interrupted;
        let row = |row| Some(row).filter(is_whole).map(PrimaryPoint::from_row);
        Ok(rows.iter().map(row).collect())
    })
}

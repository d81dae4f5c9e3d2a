//! `lindstedt simulate PROBLEM` of an equation or a mechanism of its own.

use crate::Symbol;
use crate::export::json::points::MotionPoint;
use crate::export::{decimal, json, trajectory};
use crate::expr::Expr;
use crate::impact::sweep::{grid_size, grid_values};
use crate::problem::Problem;
use crate::report::{self, BasinSweep, MOST_STARTS, MotionSweep, TRUSTED, TrajectoryReport};
use crate::system::{Integrator, PathEnd, SystemError};
use crate::trajectory::{
    DISPLACEMENT, PoincareSection, SweptMotion, Trajectory, TrajectoryError, TrajectoryRequest,
    in_words, sweep, sweep_to_attractors,
};
use crate::verify::Verdict;
use crate::wall::WallError;

use super::answer::{Answer, no_such};
use super::derive::exact_values;
use super::files::width;
use super::problem::{expression, value_name};
use super::progress::{MOTIONS, PartsBar};
use super::session;
use super::shard::{self, Points};
use super::simulate::{Method, SimulateArguments, TOGETHER, check_format, check_samples, inputs};
use super::{Failure, Format, Outcome, json_text, values_of};

pub(super) fn run(problem: &Problem, asked: &SimulateArguments) -> Result<Outcome, Failure> {
    let common = &asked.common;
    check_format(common)?;
    let course = course(problem, asked)?;
    if !asked.sweep.is_empty() {
        return run_sweep(&course, asked);
    }
    check_samples(&asked.sample, course.duration, "--until")?;
    let by = |integrator: Integrator| course.clone().follow_by(integrator).map_err(refused);
    let (motion, judge) = match asked.integrator {
        None => (course.clone().follow().map_err(refused)?, None),
        Some(Method::Taylor) => (by(Integrator::Taylor)?, None),
        Some(Method::RungeKutta) => (by(Integrator::RungeKutta)?, None),
        Some(Method::Both) => {
            let [motion, judge] = by_both(&course)?;
            (motion, Some(judge))
        }
    };
    let known_until = motion.known_until();
    let report = TrajectoryReport {
        motion: &motion,
        judge: judge.as_ref(),
        samples: &asked.sample,
        known_until,
        lyapunov: match asked.lyapunov || known_until.is_some() {
            true => motion.lyapunov_exponent(),
            false => None,
        },
    };
    if asked.lyapunov && report.lyapunov.is_none() {
        return Err(Failure::because(
            "no Lyapunov exponent: the motion ends early, or motions nearby fall together with it, as where friction holds it\n  help: leave out --lyapunov"
                .to_owned(),
        ));
    }
    let answer = Answer {
        document: &report::trajectory(&report),
        width: width(common.output.as_deref()),
        picture: Some(&|| Ok(trajectory::picture(&report)?)),
        other: &|format| match format {
            Format::Csv => Ok(trajectory::csv(&report)),
            Format::Json => json_text(&json::motion(&report)),
            format => no_such(format),
        },
    };
    let broken =
        [Some(&motion), judge.as_ref()].into_iter().flatten().find(|motion| !motion.is_complete());
    let allowed = common.tolerance.unwrap_or(TRUSTED);
    let doubt = report.doubt();
    // A section is looked at for what motions nearby have in common.
    let known = report.known_until.filter(|_| course.section.is_none());
    let warning = match (broken, doubt) {
        (Some(motion), _) => Some(format!(
            "stopped early, what there is is kept: {}{}",
            in_words(motion.reason()),
            match motion.reason() {
                PathEnd::StepLimit => ", which --step-limit raises",
                _ => "",
            }
        )),
        (None, Some(doubt)) => Some(doubt.to_string()),
        (None, None) => known.map(|known| {
            format!(
                "six digits hold until t = {} only: then a start displaced by {DISPLACEMENT:e} of it is elsewhere",
                decimal(known)
            )
        }),
    };
    Ok(Outcome {
        note: warning.map(|warning| format!("warning: {warning}")),
        verdict: Some(verdict(&motion, judge.as_ref(), allowed)),
        partial: !report.is_complete(),
        ..answer.outcome(common)?
    })
}

/// The motion by power series, and by Runge-Kutta beside it.
///
/// # Errors
/// The series end at a point that Runge-Kutta passes: there is nothing to compare.
fn by_both(course: &TrajectoryRequest) -> Result<[Trajectory; 2], Failure> {
    let by = |integrator: Integrator| course.clone().follow_by(integrator);
    let end = match by(Integrator::Taylor) {
        Ok(motion) if motion.reason() != PathEnd::Singular => {
            return Ok([motion, by(Integrator::RungeKutta).map_err(refused)?]);
        }
        Err(error @ TrajectoryError::System(SystemError::Start(_))) => Err(error),
        other => Ok(other.map_err(refused)?),
    };
    let judge = by(Integrator::RungeKutta);
    let passed = match (&end, &judge) {
        (Ok(series), Ok(judge)) => {
            judge.is_complete() || judge.end() > series.end() * (1.0 + TRUSTED)
        }
        (Err(_), Ok(judge)) => judge.end() > 0.0,
        (_, Err(_)) => false,
    };
    match end {
        Ok(series) if !passed => Ok([series, judge.map_err(refused)?]),
        Err(error) if !passed => Err(refused(error)),
        end => {
            let end = end.map_or(0.0, |series| series.end());
            let judged = match course.energy {
                Some(_) => ", and its energy is accounted for",
                None => "",
            };
            Err(Failure::because(format!(
                "no second integrator: the power series end at t = {}, where the rates have none, as at rest exactly at the touch of a \
                 contact in d^(3/2), and Runge-Kutta goes on alone\n  help: leave out --integrator: the motion is followed by Runge-Kutta{judged}",
                decimal(end)
            )))
        }
    }
}

fn refused(error: TrajectoryError) -> Failure {
    let help = match &error {
        TrajectoryError::Missing(names) => {
            Some(format!("{}, or [values] in the file", values_of(names)))
        }
        TrajectoryError::Wall(WallError::WithoutMass(_)) => Some(
            "write each equation with its mass before the acceleration, m1*x'' + ... = 0"
                .to_owned(),
        ),
        TrajectoryError::BehindWall { .. } => Some(
            "give a start on the allowed side with --from, or reverse the inequality of --wall"
                .to_owned(),
        ),
        TrajectoryError::Unknown(_) => Some(
            "its start is given by --from x=1, say, and the values of parameters by --at"
                .to_owned(),
        ),
        _ => None,
    };
    Failure::refused(&error, help)
}

/// The course of the file with the start, the values and the duration of the command line.
fn course(problem: &Problem, asked: &SimulateArguments) -> Result<TrajectoryRequest, Failure> {
    let mut course = problem.course().map_err(|error| Failure::refused(&error, error.help()))?;
    course = course.with_walls(asked.walls.walls(problem)?);
    let events = asked.events.events(problem, &course.rates.states)?;
    course = course.with_events(events);
    if let Some(text) = &asked.static_friction {
        let ratio = expression(text)
            .map_err(|error| Failure::Usage(format!("--static-friction {text}: {error}")))?;
        course.static_friction = Some(ratio);
    }
    course.section = section(&course, asked)?;
    let needed = course.parameters();
    let values = exact_values(&asked.at, problem.values_with(&needed))?.unwrap_or_default();
    if let Some(unknown) = values.numbers().into_keys().find(|name| !needed.contains(name)) {
        return Err(refused(TrajectoryError::Unknown(unknown)));
    }
    course.values = values.numbers();
    course.after = asked.after.unwrap_or(0.0);
    course.interrupt = session::interrupt();
    if let Some(until) = asked.until {
        course.duration = until;
    }
    if let Some(limit) = asked.step_limit {
        course.step_limit = limit as usize;
    }
    if course.after > 0.0 && course.after >= course.duration {
        return Err(Failure::because(format!(
            "--after {} leaves nothing of the duration {}\n  help: raise --until",
            course.after, course.duration
        )));
    }
    if course.after > 0.0 && course.section.is_none() && asked.sweep.is_empty() {
        return Err(Failure::Usage(
            "--after belongs to a section or a sweep: give --every, --section or --sweep"
                .to_owned(),
        ));
    }
    let starts_swept =
        asked.sweep.iter().any(|axis| course.rates.states.contains(&Symbol::new(axis.name())));
    if asked.from.is_empty() && !starts_swept {
        let name = course.coordinates.first().map_or("x", |name| name.name());
        let is_missing = |name: &Symbol| {
            !course.values.contains_key(name)
                && asked.sweep.iter().all(|axis| axis.name() != name.name())
        };
        let missing: Vec<Symbol> = needed.iter().copied().filter(is_missing).collect();
        let (and_values, at) = match missing.is_empty() {
            true => (String::new(), String::new()),
            false => {
                let names: Vec<String> = missing.iter().map(|name| format!("`{name}`")).collect();
                (
                    format!(" and values of {}", names.join(", ")),
                    " ".to_owned() + &values_of(&missing),
                )
            }
        };
        // The states of an equation of first order begin without a velocity.
        let has_velocity = course
            .rates
            .states
            .iter()
            .any(|state| state.coordinate().name() == name && state.name() != name);
        let for_a_blow = match has_velocity {
            true => {
                format!(" for a release from rest, --from \"{name}=0,{name}'=1\"{at} for a blow")
            }
            false => String::new(),
        };
        return Err(Failure::because(format!(
            "a motion needs its start{and_values}\n  help: --from {name}=1.5{at}{for_a_blow}"
        )));
    }
    let mut begun: Vec<Symbol> = Vec::new();
    for part in asked.from.iter().flat_map(|text| text.split(',')) {
        let form =
            || Failure::Usage(format!("--from {part}: expected NAME=VALUE, such as x=1.5 or v=0"));
        let (name, value) = part.split_once('=').ok_or_else(form)?;
        let value =
            expression(value).map_err(|error| Failure::Usage(format!("--from {part}: {error}")))?;
        let number = value.evaluate(&Default::default()).map_err(|_| form())?;
        let name = match (value_name(name), course.coordinates.as_slice()) {
            // With one coordinate there is no doubt whose velocity is meant.
            (name, [only]) if name.name() == "v" && only.name() != "v" => only.derivative(),
            (name, _) => name,
        };
        if begun.contains(&name) {
            return Err(Failure::Usage(format!("--from gives `{name}` twice")));
        }
        begun.push(name);
        course.begin(name, number).map_err(refused)?;
    }
    Ok(course)
}

/// The section asked for.
fn section(
    course: &TrajectoryRequest,
    asked: &SimulateArguments,
) -> Result<Option<PoincareSection>, Failure> {
    let read = |option: &str, text: &str| {
        expression(text).map_err(|error| Failure::Usage(format!("--{option} {text}: {error}")))
    };
    let moves = |expression: &Expr| {
        let states = &course.rates.states;
        expression.contains(Symbol::new("t"))
            || states.iter().any(|state| expression.contains(*state))
    };
    match (asked.every.as_deref(), asked.section.as_deref()) {
        (Some(text), _) => match read("every", text)? {
            period if moves(&period) => Err(Failure::Usage(format!(
                "--every {text}: a period does not depend on the motion; for where something grows through zero: --section"
            ))),
            period => Ok(Some(PoincareSection::Every(period))),
        },
        (None, Some("impacts")) if course.walls.is_empty() => Err(Failure::Usage(
            "--section impacts: there are no impacts without a wall: give --wall \"x < 1\", or [[wall]] in the file"
                .to_owned(),
        )),
        (None, Some("impacts")) => Ok(Some(PoincareSection::Impacts)),
        (None, Some("events")) if course.events.is_empty() => Err(Failure::Usage(
            "--section events: there are no events: give --event \"x > 1: x' = -x'\", or [[event]] in the file"
                .to_owned(),
        )),
        (None, Some("events")) => Ok(Some(PoincareSection::Events)),
        (None, Some(text)) => match read("section", text)? {
            expression if moves(&expression) => Ok(Some(PoincareSection::Rising(expression))),
            _ => Err(Failure::Usage(format!(
                "--section {text}: never grows through zero, for it does not depend on the motion; for equal times: --every"
            ))),
        },
        (None, None) => Ok(None),
    }
}

/// Many motions.
fn run_sweep(course: &TrajectoryRequest, asked: &SimulateArguments) -> Result<Outcome, Failure> {
    let common = &asked.common;
    if asked.integrator.is_some() || !asked.sample.is_empty() || common.tolerance.is_some() {
        return Err(Failure::Usage(
            "a sweep reports one line a motion and has no verdict: leave out --integrator, --sample and --tolerance"
                .to_owned(),
        ));
    }
    let names: Vec<Symbol> = asked.sweep.iter().map(|axis| Symbol::new(axis.name())).collect();
    let are_starts = names.iter().all(|name| course.rates.states.contains(name));
    let has_basins = names.len() == 2 && are_starts && course.section.is_some();
    if names.len() > 1 && !has_basins && common.draws() {
        return Err(Failure::Usage(
            "--plot draws the motions over one parameter, or basins over two coordinates or velocities of the start with --every or --section: leave out --plot"
                .to_owned(),
        ));
    }
    let parameters = course.parameters();
    for (index, name) in names.iter().enumerate() {
        if !parameters.contains(name) && !course.rates.states.contains(name) {
            let known: Vec<String> =
                parameters.iter().chain(&course.rates.states).map(ToString::to_string).collect();
            return Err(Failure::because(format!(
                "--sweep: `{name}` is neither a parameter nor a state of the equations, so nothing would vary: choose one of {}",
                known.join(", ")
            )));
        }
        if names[..index].contains(name) {
            return Err(Failure::Usage(format!("--sweep: `{name}` is swept twice")));
        }
        if course.values.contains_key(name) {
            return Err(Failure::Usage(format!(
                "`{name}` is swept and has a value beside: give one of them"
            )));
        }
    }
    let total = grid_size(&asked.sweep)?;
    let grid: Vec<Vec<f64>> = (0..total).map(|number| grid_values(&asked.sweep, number)).collect();
    let failed = |number: usize, error: TrajectoryError| {
        refused(error).within(&format!("motion {}", number + 1))
    };
    if let Some(shard) = asked.shard.shard {
        let points = Points {
            total,
            together: TOGETHER,
            bar: MOTIONS,
            inputs: &|index| inputs(&asked.sweep, index),
        };
        return shard::write(shard, common, &points, |indices| {
            let own: Vec<Vec<f64>> = indices.iter().map(|index| grid[*index].clone()).collect();
            let motions = sweep(course, &names, &own, || ())
                .map_err(|(number, error)| failed(indices[number], error))?;
            // After an interrupt there are fewer motions than were asked for.
            let whole = motions.iter().filter(|motion| motion.reason != PathEnd::Interrupted);
            let whole: Vec<&SweptMotion> = whole.collect();
            let row = |values: &Vec<f64>| {
                let motion = whole.iter().find(|motion| motion.values == *values)?;
                Some(MotionPoint::from_motion(motion))
            };
            Ok(own.iter().map(row).collect())
        });
    }
    let motions = match shard::known::<MotionPoint>(total)? {
        Some(rows) => {
            let read = |(index, row): (usize, &MotionPoint)| {
                row.read(grid[index].clone()).ok_or_else(|| shard::unreadable(index))
            };
            rows.iter().enumerate().map(read).collect::<Result<_, _>>()?
        }
        None if has_basins && shows_basins_alone(asked, total) => {
            let [across, up] = [names[0], names[1]];
            let bar = PartsBar::new(total, MOTIONS);
            let found = sweep_to_attractors(course, &names, &grid, || bar.advance(1))
                .map_err(|(number, error)| failed(number, error))?;
            bar.finish();
            let report = BasinSweep {
                course,
                names: [across, up],
                starts: &found.starts,
                basins: &found.basins,
            };
            let answer = Answer {
                document: &report::basin_sweep(&report),
                width: width(common.output.as_deref()),
                picture: Some(&|| Ok(trajectory::basins_picture(&report)?)),
                other: &no_such,
            };
            let note = ended_early(found.starts.len(), &found.ended, total);
            return Ok(Outcome { partial: note.is_some(), note, ..answer.outcome(common)? });
        }
        None => {
            let bar = PartsBar::new(total, MOTIONS);
            let motions = sweep(course, &names, &grid, || bar.advance(1))
                .map_err(|(number, error)| failed(number, error))?;
            bar.finish();
            motions
        }
    };
    let report = MotionSweep { course, names: &names, motions: &motions };
    let answer = Answer {
        document: &report::motion_sweep(&report),
        width: width(common.output.as_deref()),
        picture: Some(&|| Ok(trajectory::sweep_picture(&report)?)),
        other: &|format| match format {
            Format::Csv => Ok(trajectory::sweep_csv(&report)),
            Format::Json => json_text(&json::motion_sweep(&report)),
            format => no_such(format),
        },
    };
    let note = stopped_early(&motions, total);
    Ok(Outcome { partial: note.is_some(), note, ..answer.outcome(common)? })
}

/// Whether of so many motions their attractors alone are written, and no motion: not as numbers, and not in the other
/// formats that a caller may ask for later.
fn shows_basins_alone(asked: &SimulateArguments, total: usize) -> bool {
    let is_read = matches!(asked.common.format(), Format::Csv | Format::Json);
    total > MOST_STARTS && !is_read && !session::current().is_call()
}

/// The part that is missing of this number of motions, in words; `None` if nothing is.
fn stopped_early(motions: &[SweptMotion], all: usize) -> Option<String> {
    let reasons = motions.iter().map(|motion| motion.reason).enumerate();
    let ended: Vec<_> = reasons.filter(|(_, reason)| *reason != PathEnd::Reached).collect();
    ended_early(motions.len(), &ended, all)
}

/// The same of this number of motions, of which those of these numbers ended early.
fn ended_early(begun: usize, ended: &[(usize, PathEnd)], all: usize) -> Option<String> {
    let kept = "stopped early, what there is is kept";
    let interrupted = ended.iter().filter(|(_, reason)| *reason == PathEnd::Interrupted).count();
    if begun < all || interrupted > 0 {
        let cut = match interrupted {
            0 => String::new(),
            some => format!(", {some} of them not to the end"),
        };
        return Some(format!("warning: {kept}: {begun} of {all} motions{cut}"));
    }
    let (number, reason) = ended.first()?;
    Some(format!("warning: motion {} {kept}: {}", number + 1, in_words(*reason)))
}

/// Complete, the energy accounted for, and where there is a judge, agreed with.
fn verdict(motion: &Trajectory, judge: Option<&Trajectory>, allowed: f64) -> Verdict {
    let kept = motion.balance.as_ref().is_none_or(|balance| balance.residual <= allowed);
    let agreed =
        judge.is_none_or(|judge| judge.is_complete() && motion.difference(judge) <= allowed);
    Verdict::from_passed(kept && agreed && motion.is_complete())
}

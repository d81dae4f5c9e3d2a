//! `lindstedt simulate PROBLEM` of an equation or a mechanism of its own.

use lindstedt::export::{json, significant, text, trajectory};
use lindstedt::expr::parse_expression;
use lindstedt::problem::Problem;
use lindstedt::report::{self, TrajectoryReport};
use lindstedt::system::Integrator;
use lindstedt::trajectory::{Course, Trajectory, TrajectoryError, in_words};
use lindstedt::verify::Verdict;
use lindstedt::{Interrupt, Symbol};

use super::derive::exact_values;
use super::files::width;
use super::{Common, Failure, Format, Outcome, STOP, json_text, whole};

/// What is asked of a motion of one's own.
pub(super) struct Asked<'a> {
    /// `x=1.5,v=0`.
    pub from: &'a [String],
    /// How long.
    pub until: Option<f64>,
    /// Values of parameters.
    pub at: &'a [String],
    /// Times at which the state is wanted.
    pub samples: &'a [f64],
    /// By Runge-Kutta alone, by power series alone or by both.
    pub integrators: &'a [Integrator],
    pub common: &'a Common,
}

/// Without `--tolerance`: the energy that may go astray, and the difference of two integrators.
const TOLERANCE: f64 = 1e-6;

pub(super) fn run(problem: &Problem, asked: &Asked) -> Result<Outcome, Failure> {
    let common = asked.common;
    if common.format == Format::Latex {
        return Err(Failure::Usage(
            "a simulation has no LaTeX form, for it has no formulas: choose --format text, json or csv".to_owned(),
        ));
    }
    let course = course(problem, asked)?;
    if let Some(late) = asked.samples.iter().find(|sample| **sample > course.duration) {
        return Err(Failure::Refused(format!(
            "--sample {late} lies beyond the duration {}\n  help: raise --until",
            course.duration
        )));
    }
    let by = |integrator: Integrator| course.clone().follow_by(integrator).map_err(refused);
    let (motion, judge) = match asked.integrators {
        [] => (course.clone().follow().map_err(refused)?, None),
        [only] => (by(*only)?, None),
        [first, second, ..] => (by(*first)?, Some(by(*second)?)),
    };
    let report = TrajectoryReport {
        motion: &motion,
        judge: judge.as_ref(),
        samples: asked.samples,
    };
    let text = match common.format {
        Format::Csv => trajectory::csv(&report),
        Format::Json => json_text(&json::motion(&report))?,
        Format::Text | Format::Latex => text::document(&report::trajectory(&report), width(common.output.as_deref())),
    };
    let picture = common.plot.as_ref().map(|path| (path.clone(), picture(&report)));
    let broken = [Some(&motion), judge.as_ref()]
        .into_iter()
        .flatten()
        .find(|motion| !motion.is_complete());
    let allowed = common.tolerance.unwrap_or(TOLERANCE);
    let doubtful = match (motion.balance, &judge) {
        (Some(balance), _) if balance.residual > TOLERANCE => Some(format!(
            "warning: {} of the largest energy is not accounted for: do not trust this motion",
            significant(balance.residual, 2)
        )),
        (_, Some(judge)) if motion.difference(judge) > TOLERANCE => Some(format!(
            "warning: the two integrators differ by {} of the largest displacement: do not trust this motion so far",
            significant(motion.difference(judge), 2)
        )),
        _ => None,
    };
    Ok(Outcome {
        result: whole(text),
        picture,
        note: match broken {
            Some(motion) => Some(format!(
                "warning: stopped early, what there is is kept: {}",
                in_words(motion.reason())
            )),
            None => doubtful,
        },
        verdict: Some(verdict(&motion, judge.as_ref(), allowed)),
        partial: broken.is_some(),
    })
}

fn refused(error: TrajectoryError) -> Failure {
    let help = match &error {
        TrajectoryError::Missing(names) => names
            .first()
            .map(|name| format!("--at {name}=VALUE, or [values] in the file")),
        _ => None,
    };
    Failure::refused(&error, help)
}

/// The course of the file with the start, the values and the duration of the command line.
fn course(problem: &Problem, asked: &Asked) -> Result<Course, Failure> {
    let mut course = problem
        .course()
        .map_err(|error| Failure::refused(&error, error.help()))?;
    let values = exact_values(asked.at, problem)?.unwrap_or_default();
    let needed = course.parameters();
    if let Some(unknown) = values.numbers().into_keys().find(|name| !needed.contains(name)) {
        return Err(refused(TrajectoryError::Unknown(unknown)));
    }
    course.values = values.numbers();
    course.interrupt = Interrupt::by(&STOP);
    if let Some(until) = asked.until {
        course.duration = until;
    }
    if asked.from.is_empty() {
        let name = course.coordinates.first().map_or("x", |name| name.name());
        return Err(Failure::Refused(format!(
            "a motion needs its start\n  help: --from {name}=1.5 for a release from rest, --from \"{name}=0,{name}'=1\" for a blow"
        )));
    }
    let mut begun: Vec<Symbol> = Vec::new();
    for part in asked.from.iter().flat_map(|text| text.split(',')) {
        let form = || Failure::Usage(format!("--from {part}: expected NAME=VALUE, such as x=1.5 or v=0"));
        let (name, value) = part.split_once('=').ok_or_else(form)?;
        let value = parse_expression(value).map_err(|error| Failure::Usage(format!("--from {part}: {error}")))?;
        let number = value.evaluate(&Default::default()).map_err(|_| form())?;
        let name = match (name.trim(), course.coordinates.as_slice()) {
            // With one coordinate there is no doubt whose velocity is meant.
            ("v", [only]) if only.name() != "v" => only.derivative(),
            (name, _) => Symbol::new(name),
        };
        if begun.contains(&name) {
            return Err(Failure::Usage(format!("--from gives `{name}` twice")));
        }
        begun.push(name);
        course.begin(name, number).map_err(refused)?;
    }
    Ok(course)
}

/// Complete, the energy accounted for, and where there is a judge, agreed with.
fn verdict(motion: &Trajectory, judge: Option<&Trajectory>, allowed: f64) -> Verdict {
    let kept = motion.balance.is_none_or(|balance| balance.residual <= allowed);
    let agreed = judge.is_none_or(|judge| judge.is_complete() && motion.difference(judge) <= allowed);
    Verdict::of(kept && agreed && motion.is_complete())
}

#[cfg(not(feature = "plot"))]
fn picture(_: &TrajectoryReport) -> Result<String, Failure> {
    super::no_pictures()
}

#[cfg(feature = "plot")]
fn picture(report: &TrajectoryReport) -> Result<String, Failure> {
    trajectory::picture(report).map_err(|error| Failure::refused(&error, None))
}

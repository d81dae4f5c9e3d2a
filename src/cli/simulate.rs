//! `lindstedt simulate [PROBLEM]`.

use std::io::Write;
use std::path::Path;

use crate::export::json;
use crate::export::json::points::SweepPoint;
use crate::export::json::shard::Shard;
use crate::export::simulation::{
    Report, SweepReport, csv, figure, html, latex, sweep_csv, sweep_html, sweep_text, text,
};
use crate::export::text::fitted;
use crate::impact::sweep::{Axis, AxisError, Summary, grid_size, grid_values, sweep, sweep_on};
use crate::impact::{
    BASELINE_DURATIONS, Integrator, Model, Parameter, Settings, Simulation, SimulationError,
    SimulationStop, Start, baseline, known_until, simulate,
};
use crate::problem::{Problem, ProblemError, Simulate};
use crate::verify::Verdict;
use clap::{Args, ValueEnum};
use serde_json::{Map, Value};

use super::answer::{Draw, drawn, no_such, page, pictured};
use super::files::width;
use super::primary;
use super::problem::problem;
use super::progress::{MOTIONS, PartsBar};
use super::session;
use super::shard::{self, Points, ShardArguments};
use super::trajectory;
use super::walls::{ContactArguments, EventArguments, WallArguments};
use super::{Common, Failure, Format, Outcome, Work, json_text, text_writer};

/// The paper's equation (7) in full, event by event: trajectory, impacts, energy, rest time; or any
/// equation or mechanism
#[derive(Args)]
pub struct SimulateArguments {
    /// A TOML file, - for standard input, an equation in quotes or a name of the catalogue; without
    /// it the paper's pendulum and barrier
    pub problem: Option<String>,
    /// Where an equation or a mechanism of one's own begins (x=1.5,v=0; "a=1,b'=2"): what is left
    /// out is 0
    #[arg(long, value_name = "x=VALUE", allow_hyphen_values = true)]
    pub(super) from: Vec<String>,
    /// How long it is followed; 50 without it
    #[arg(long, value_name = "T", value_parser = super::positive, allow_hyphen_values = true)]
    pub(super) until: Option<f64>,
    /// Steps of the integrator after which it ends; 250 000 without it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    pub(super) step_limit: Option<u32>,
    /// A value of one of its parameters (1.5, 3/2, pi/3); repeatable
    #[arg(long, value_name = "NAME=VALUE,...")]
    pub(super) at: Vec<String>,
    #[command(flatten)]
    pub(super) walls: WallArguments,
    #[command(flatten)]
    pub(super) events: EventArguments,
    /// Static over sliding friction, 1 or more: what dry friction, mu*sgn(x'), holds, it holds up to so
    /// many times the force with which it slides (1.5, mus/muk)
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    pub(super) static_friction: Option<String>,
    #[command(flatten)]
    contacts: ContactArguments,
    /// Look at an equation or a mechanism of one's own once in this time (Poincaré's section):
    /// 2*pi/Omega
    #[arg(long, value_name = "PERIOD", conflicts_with = "section")]
    pub(super) every: Option<String>,
    /// Look at it where an expression of its coordinates, velocities and the time grows through
    /// zero: x', "x - 0.1"; or just before each impact on a wall: impacts; or each event: events
    #[arg(long, value_name = "EXPRESSION", allow_hyphen_values = true)]
    pub(super) section: Option<String>,
    /// Look at it from this time on, when it has settled
    #[arg(long, value_name = "T", value_parser = time, allow_hyphen_values = true)]
    pub(super) after: Option<f64>,
    /// Report the state at this time (repeatable)
    #[arg(long, value_name = "T", value_parser = time, allow_hyphen_values = true)]
    pub(super) sample: Vec<f64>,
    /// Give the largest Lyapunov exponent of an equation or a mechanism of one's own, with its standard
    /// error; without it where six digits are lost on the way
    #[arg(long, conflicts_with = "sweep")]
    pub(super) lyapunov: bool,
    /// The method: power series with the contact in a variable in which it is analytic;
    /// Runge-Kutta, one smooth phase at a time; or both, and how far they differ
    #[arg(long, value_enum)]
    pub(super) integrator: Option<Method>,
    /// Do not integrate: swing and contact in closed form, impact after impact to rest, each with
    /// its formula, and its error against the integration; with [primary] main mass and pendulum
    /// together; a sweep is not judged
    #[arg(long, conflicts_with = "integrator")]
    pub(super) chain: bool,
    /// Follow many motions: a parameter over a range by equal steps, by equal ratios
    /// (from:to:count:log), or at the values of a list (NAME=a,b,c); repeated, over every
    /// combination
    #[arg(long, value_name = "NAME=from:to:count", value_parser = axis, allow_hyphen_values = true)]
    pub(super) sweep: Vec<Axis>,
    /// In a sweep: beside each rest time those without a barrier and with one that loses nothing
    #[arg(long, requires = "sweep")]
    baseline: bool,
    /// Threads of a sweep; all cores without it. The result is the same for any number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    #[command(flatten)]
    pub(super) shard: ShardArguments,
    #[command(flatten)]
    pub common: Common,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Method {
    Taylor,
    RungeKutta,
    Both,
}

fn time(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("expected a time, 0 or later".to_owned()),
    }
}

fn axis(text: &str) -> Result<Axis, String> {
    text.parse().map_err(|error: AxisError| error.to_string())
}

/// Without `--tolerance`: the energy that may go astray, relative to the largest.
const ENERGY_TOLERANCE: f64 = 1e-6;

impl Work for SimulateArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn input(&self) -> Option<&Path> {
        self.problem.as_deref().and_then(super::problem::path)
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &SimulateArguments) -> Result<Outcome, Failure> {
    if arguments.shard.shard.is_some() && arguments.sweep.is_empty() {
        return Err(Failure::Usage(
            "--shard splits a sweep: leave it out, or give --sweep".to_owned(),
        ));
    }
    let problem = match &arguments.problem {
        None => Problem::default(),
        Some(text) => arguments.contacts.on(problem(text)?)?,
    };
    if problem.equation.is_some() || problem.lagrangian.is_some() {
        return run_equation(arguments, &problem);
    }
    let foreign = [
        ("--from", !arguments.from.is_empty(), "start and speed in [pendulum]"),
        ("--until", arguments.until.is_some(), "duration in [run]"),
        ("--step-limit", arguments.step_limit.is_some(), "step_limit in [run]"),
        ("--at", !arguments.at.is_empty(), "the keys of a file"),
        ("--wall", !arguments.walls.wall.is_empty(), "barrier in [pendulum]"),
        ("--restitution", !arguments.walls.restitution.is_empty(), "restitution in [contact]"),
        ("--event", !arguments.events.event.is_empty(), "barrier in [pendulum]"),
        ("--static-friction", arguments.static_friction.is_some(), "friction in [damping]"),
        ("--contact", !arguments.contacts.contact.is_empty(), "[contact]"),
        ("--every", arguments.every.is_some(), "--sample"),
        ("--section", arguments.section.is_some(), "--sample"),
        ("--lyapunov", arguments.lyapunov, "--sample"),
        ("--after", arguments.after.is_some(), "--sample"),
    ];
    if let Some((option, _, instead)) = foreign.iter().find(|(_, given, _)| *given) {
        return Err(Failure::Usage(format!(
            "{option} belongs to an equation or a mechanism of one's own; for the pendulum and its barrier give {instead}"
        )));
    }
    if problem.primary.is_some() {
        return main_mass(arguments, &problem);
    }
    if arguments.common.format() == Format::Latex && !arguments.sweep.is_empty() {
        return Err(Failure::Usage(
            "a sweep has no LaTeX form: choose --format text, json or csv".to_owned(),
        ));
    }
    if arguments.common.format() == Format::Latex && !arguments.chain {
        return Err(Failure::Usage(
            "a simulation has no LaTeX form, for it has no formulas: choose --format text, json or csv, or --chain"
                .to_owned(),
        ));
    }
    if arguments.sweep.is_empty() && arguments.jobs.is_some() {
        return Err(Failure::Usage(
            "--jobs are the threads of a sweep: leave it out, or give --sweep".to_owned(),
        ));
    }
    match arguments.sweep.is_empty() {
        true => run_single(arguments, &problem),
        false => run_sweep(arguments, &problem),
    }
}

/// A main mass that carries the pendulum.
fn main_mass(arguments: &SimulateArguments, problem: &Problem) -> Result<Outcome, Failure> {
    let foreign = [
        ("--integrator", arguments.integrator.is_some()),
        ("--baseline", arguments.baseline),
        ("--jobs", arguments.jobs.is_some()),
    ];
    if let Some((option, _)) = foreign.iter().find(|(_, given)| *given) {
        return Err(Failure::Usage(format!(
            "{option} belongs to the pendulum alone: a file with [primary] is followed by power series or by --chain, on all \
             cores where something is swept"
        )));
    }
    primary::run(problem, arguments)
}

/// An equation or a mechanism of one's own.
fn run_equation(arguments: &SimulateArguments, problem: &Problem) -> Result<Outcome, Failure> {
    let foreign = [
        ("--chain", arguments.chain),
        ("--jobs", arguments.jobs.is_some()),
        ("--baseline", arguments.baseline),
    ];
    if let Some((option, _)) = foreign.iter().find(|(_, given)| *given) {
        return Err(Failure::Usage(format!(
            "{option} belongs to the pendulum and its barrier: an equation or a mechanism of one's own is followed by integration, on all \
             cores where something is swept"
        )));
    }
    trajectory::run(problem, arguments)
}

/// Refuses LaTeX, which has no form for numbers alone.
pub(super) fn check_format(common: &Common) -> Result<(), Failure> {
    match common.format() {
        Format::Latex => Err(Failure::Usage(
            "a simulation has no LaTeX form, for it has no formulas: choose --format text, json or csv".to_owned(),
        )),
        _ => Ok(()),
    }
}

/// Refuses times of states beyond the end, and says where that is given.
pub(super) fn check_samples(samples: &[f64], duration: f64, given: &str) -> Result<(), Failure> {
    match samples.iter().find(|sample| **sample > duration) {
        None => Ok(()),
        Some(late) => Err(Failure::because(format!(
            "--sample {late} lies beyond the duration {duration}\n  help: raise {given}"
        ))),
    }
}

/// Refuses to vary what all motions of a sweep share.
pub(super) fn check_varied(axes: &[Axis]) -> Result<(), Failure> {
    let shared =
        |axis: &&Axis| ["duration", "integrator_tolerance", "step_limit"].contains(&axis.name());
    match axes.iter().find(shared) {
        None => Ok(()),
        Some(axis) => Err(Failure::because(format!(
            "`{}` is the same for all motions of a sweep: give it in [run]",
            axis.name()
        ))),
    }
}

fn refused(error: ProblemError) -> Failure {
    let help = error.help();
    Failure::refused(&error, help)
}

fn run_single(arguments: &SimulateArguments, problem: &Problem) -> Result<Outcome, Failure> {
    let asked = Simulate::try_from(problem).map_err(refused)?;
    let (model, start) = asked.case.motion().map_err(|error| refused(error.into()))?;
    let settings = settings(arguments, &asked);
    check_samples(&arguments.sample, settings.duration, "`duration` in [run]")?;
    let follow = |integrator| simulate(&model, start, integrator, &settings);
    let integrator = arguments.integrator.unwrap_or(Method::Taylor);
    let motion = match integrator {
        _ if arguments.chain => follow(Integrator::Chain)?,
        Method::RungeKutta => follow(Integrator::RungeKutta)?,
        Method::Taylor | Method::Both => follow(Integrator::Taylor)?,
    };
    let judge = match integrator {
        _ if arguments.chain => Some(follow(Integrator::Taylor)?),
        Method::Both => Some(follow(Integrator::RungeKutta)?),
        Method::Taylor | Method::RungeKutta => None,
    };
    let others = baseline(&motion)?;
    let units = asked.units.as_ref();
    let dissipation = asked.case.dissipation(units).map_err(|error| refused(error.into()))?;
    let report = Report {
        motion: &motion,
        baseline: others.as_ref(),
        judge: judge.as_ref(),
        sources: [asked.gamma_source, asked.mu_source],
        tolerance: problem.run.integrator_tolerance,
        samples: &arguments.sample,
        dissipation: Some(&dissipation),
        units,
        known_until: if arguments.chain { None } else { known_until(&motion) },
    };
    let draw: Option<Draw> = Some(&|| Ok(figure::simulation(&report)?));
    let written = |format: Format| -> Result<String, Failure> {
        Ok(match format {
            Format::Csv => csv(&report),
            Format::Json => json_text(&json::simulation(&report))?,
            Format::Text => fitted(&text(&report), width(arguments.common.output.as_deref())),
            Format::Latex if !arguments.chain => return no_such(format),
            Format::Latex => arguments.common.latex(latex(&report)),
            Format::Html => page(draw, None, |page| html(&report, page)),
            Format::Svg => drawn(draw)?,
            format => no_such(format)?,
        })
    };
    let text = written(arguments.common.format())?;
    session::current().keep_forms(arguments.common.format(), written);
    let picture = pictured(&arguments.common, draw);
    let broken = [Some(&motion), judge.as_ref()]
        .into_iter()
        .flatten()
        .find(|motion| !motion.stop.is_complete());
    let note = broken
        .map(|motion| format!("warning: stopped early, what there is is kept: {}", motion.stop));
    Ok(Outcome {
        result: text_writer(text),
        picture,
        note,
        verdict: Some(match &judge {
            Some(judge) if arguments.chain => {
                chain_verdict(&motion, judge, arguments.common.tolerance)
            }
            judge => verdict(&motion, judge.as_ref(), arguments.common.tolerance),
        }),
        partial: broken.is_some(),
    })
}

/// The settings of the file. A chain goes on to rest, unless the file says how long or nothing
/// damps the swing.
fn settings(arguments: &SimulateArguments, asked: &Simulate) -> Settings {
    let settings = Settings { interrupt: session::interrupt(), ..asked.settings };
    let damped = asked.case.motion().is_ok_and(|(model, _)| model.zeta > 0.0 || model.alpha > 0.0);
    match arguments.chain && !asked.duration_given && (damped || !arguments.sweep.is_empty()) {
        true => Settings { duration: LONGEST_CHAIN, stop_at_rest: true, ..settings },
        false => settings,
    }
}

/// The longest time for which a chain is followed to rest, in units of 1/omega.
const LONGEST_CHAIN: f64 = 1e4;

/// Without `--tolerance`: how far the rest time of a chain may be from that by integration, in
/// parts of it.
pub(super) const CHAIN_TOLERANCE: f64 = 0.01;

/// The rest time by the chain and by integration agree, or neither comes to rest and the motions
/// are near.
fn chain_verdict(motion: &Simulation, judge: &Simulation, tolerance: Option<f64>) -> Verdict {
    let allowed = tolerance.unwrap_or(CHAIN_TOLERANCE);
    let rest = motion.rest();
    let agreed = match (rest.time, judge.rest().time) {
        (Ok(found), Ok(truth)) => (found / truth - 1.0).abs() <= allowed,
        (Err(_), Err(_)) => {
            motion.difference(judge, 2001).displacement
                <= allowed * rest.amplitude.max(f64::MIN_POSITIVE)
        }
        _ => false,
    };
    Verdict::from_passed(agreed && motion.stop.is_complete() && judge.stop.is_complete())
}

/// Complete, the energy accounted for, and where there is a judge, agreed with.
fn verdict(motion: &Simulation, judge: Option<&Simulation>, tolerance: Option<f64>) -> Verdict {
    let allowed = tolerance.unwrap_or(ENERGY_TOLERANCE);
    let scale = motion.rest().amplitude.max(f64::MIN_POSITIVE);
    let agreed = judge.is_none_or(|judge| {
        judge.stop.is_complete()
            && judge.impacts.len() == motion.impacts.len()
            && motion.difference(judge, 2001).displacement <= allowed * scale
    });
    Verdict::from_passed(agreed && motion.stop.is_complete() && motion.energy().residual <= allowed)
}

/// The motions of a sweep, the last parameter varying fastest, and how to follow them.
fn motions(
    arguments: &SimulateArguments,
    problem: &Problem,
) -> Result<(Vec<(Model, Start)>, Settings), Failure> {
    let axes = arguments.sweep.as_slice();
    let total = grid_size(axes)?;
    check_varied(axes)?;
    let names: Vec<&str> = axes.iter().map(Axis::name).collect();
    if let Some(index) = (1..names.len()).find(|index| names[..*index].contains(&names[*index])) {
        return Err(Failure::Usage(format!("`{}` is swept twice", names[index])));
    }
    let named = |axis: &Axis| axis.name().parse::<Parameter>();
    let swept: Vec<Parameter> = axes
        .iter()
        .map(named)
        .collect::<Result<_, _>>()
        .map_err(|error| Failure::refused(&error, error.help()))?;
    let asked = problem.simulate(&swept).map_err(refused)?;
    let mut motions = Vec::with_capacity(total);
    for number in 0..total {
        let mut case = asked.case;
        for (parameter, value) in swept.iter().zip(grid_values(axes, number)) {
            case.set(*parameter, value);
        }
        motions.push(case.motion().map_err(|error| refused(error.into()))?);
    }
    Ok((motions, settings(arguments, &asked)))
}

/// Adds to each row the rest times of its motion without a barrier and with a lossless one.
fn add_baseline(
    rows: &mut [Summary],
    motions: &[(Model, Start)],
    settings: &Settings,
    follow: impl Fn(&[(Model, Start)], &Settings) -> Result<Vec<Summary>, (usize, SimulationError)>,
) -> Result<(), (usize, SimulationError)> {
    let longer = Settings { duration: BASELINE_DURATIONS * settings.duration, ..*settings };
    let others = |change: fn(Model) -> Model| {
        let changed: Vec<_> =
            motions.iter().map(|(model, start)| (change(*model), *start)).collect();
        follow(&changed, &longer)
    };
    let without = others(|model| Model { left: None, right: None, ..model })?;
    let lossless = others(|model| Model { mu: 0.0, ..model })?;
    for (row, (without, lossless)) in rows.iter_mut().zip(without.iter().zip(&lossless)) {
        row.baseline = Some([without.rest_time, lossless.rest_time]);
    }
    Ok(())
}

/// A row for every motion of a sweep.
fn follow_all(
    arguments: &SimulateArguments,
    motions: &[(Model, Start)],
    settings: &Settings,
) -> Result<Vec<Summary>, Failure> {
    let total = motions.len();
    let bar = PartsBar::new(if arguments.baseline { 3 * total } else { total }, MOTIONS);
    let rows = follow(arguments, motions, settings, |done| bar.advance(done));
    bar.finish();
    rows.map_err(|(number, error)| Failure::because(format!("motion {}: {error}", number + 1)))
}

/// A row for each of these motions, with its baseline where that is asked for; `progress` is called
/// with the number of motions newly done.
fn follow(
    arguments: &SimulateArguments,
    motions: &[(Model, Start)],
    settings: &Settings,
    progress: impl Fn(usize) + Sync,
) -> Result<Vec<Summary>, (usize, SimulationError)> {
    let route = match arguments.chain {
        true => Integrator::Chain,
        false => Integrator::Taylor,
    };
    let follow = |motions: &[(Model, Start)], settings: &Settings| match arguments.jobs {
        Some(threads) => sweep_on(usize::from(threads), motions, route, settings, &progress),
        None => sweep(motions, route, settings, &progress),
    };
    let mut rows = follow(motions, settings)?;
    if arguments.baseline {
        add_baseline(&mut rows, motions, settings, follow)?;
    }
    Ok(rows)
}

/// The values of the parameters of a point, by their names.
pub(super) fn inputs(axes: &[Axis], index: usize) -> Map<String, Value> {
    let names = axes.iter().map(|axis| axis.name().to_owned());
    names.zip(grid_values(axes, index).into_iter().map(Value::from)).collect()
}

/// The number of motions of a shard that are followed together: enough for all cores, and few enough
/// that a shard that is killed has written most of its lines.
pub(super) const TOGETHER: usize = 256;

/// The lines of the motions of a shard.
fn write_shard(
    shard: Shard,
    arguments: &SimulateArguments,
    motions: &[(Model, Start)],
    settings: &Settings,
) -> Result<Outcome, Failure> {
    let points = Points {
        total: motions.len(),
        together: TOGETHER,
        bar: MOTIONS,
        inputs: &|index| inputs(&arguments.sweep, index),
    };
    shard::write(shard, &arguments.common, &points, |indices| {
        let own: Vec<_> = indices.iter().map(|index| motions[*index]).collect();
        let rows = follow(arguments, &own, settings, |_| ()).map_err(|(number, error)| {
            Failure::because(format!("motion {}: {error}", indices[number] + 1))
        })?;
        let is_cut = |row: &Summary| {
            let interrupted = matches!(row.stop, SimulationStop::Interrupted { .. });
            interrupted || arguments.baseline && settings.interrupt.is_requested()
        };
        let row = |row: &Summary| (!is_cut(row)).then(|| SweepPoint::from_summary(row));
        Ok(rows.iter().map(row).collect())
    })
}

fn run_sweep(arguments: &SimulateArguments, problem: &Problem) -> Result<Outcome, Failure> {
    check_sweep(arguments)?;
    let (motions, settings) = motions(arguments, problem)?;
    let total = motions.len();
    if let Some(shard) = arguments.shard.shard {
        return write_shard(shard, arguments, &motions, &settings);
    }
    let rows = match shard::known::<SweepPoint>(total)? {
        None => follow_all(arguments, &motions, &settings)?,
        Some(rows) => {
            let read = |(index, row): (usize, &SweepPoint)| {
                row.read().ok_or_else(|| shard::unreadable(index))
            };
            rows.iter().enumerate().map(read).collect::<Result<_, _>>()?
        }
    };
    let report = SweepReport { axes: &arguments.sweep, rows: &rows };
    let draw: Option<Draw> = Some(&|| Ok(figure::sweep(&report)?));
    let picture = pictured(&arguments.common, draw);
    let incomplete = rows.iter().filter(|row| !row.stop.is_complete()).count();
    let note =
        (incomplete > 0).then(|| format!("warning: {incomplete} of {total} motions stopped early"));
    let made_whole = |format: Format| -> Result<Option<String>, Failure> {
        Ok(match format {
            Format::Svg => Some(drawn(draw)?),
            Format::Html => Some(page(draw, None, |page| sweep_html(&report, page))),
            _ => None,
        })
    };
    session::current().keep_forms(arguments.common.format(), |format| {
        let Some(write) = row_writer(format) else {
            return made_whole(format)?.map_or_else(|| no_such(format), Ok);
        };
        let mut text = Vec::new();
        write(&report, &mut text)?;
        Ok(String::from_utf8(text)?)
    });
    let write = row_writer(arguments.common.format()).unwrap_or(sweep_text);
    let made_whole = made_whole(arguments.common.format())?;
    let axes = arguments.sweep.clone();
    Ok(Outcome {
        result: match made_whole {
            Some(text) => text_writer(text),
            None => Box::new(move |to| {
                let report = SweepReport { axes: &axes, rows: &rows };
                write(&report, to)
            }),
        },
        picture,
        note,
        verdict: Some(Verdict::from_passed(incomplete == 0)),
        partial: incomplete > 0,
    })
}

/// Writes the rows of a sweep one after the other.
type RowWriter = fn(&SweepReport, &mut dyn Write) -> std::io::Result<()>;

/// The writer of the rows of a sweep in a format; `None` for a format that is made as a whole.
fn row_writer(format: Format) -> Option<RowWriter> {
    match format {
        Format::Csv => Some(sweep_csv),
        Format::Json => Some(json::sweep),
        Format::Text => Some(sweep_text),
        _ => None,
    }
}

/// Refuses options that a sweep cannot take.
fn check_sweep(arguments: &SimulateArguments) -> Result<(), Failure> {
    if arguments.sweep.len() > 2 && arguments.common.draws() {
        return Err(Failure::Usage(
            "--plot draws curves over one parameter or a map over two, but more are swept: leave out --plot, or draw a map \
             for each value of the others, given in the file"
                .to_owned(),
        ));
    }
    let other = |integrator| integrator != Method::Taylor;
    if arguments.integrator.is_some_and(other) || !arguments.sample.is_empty() {
        return Err(Failure::Usage(
            "a sweep is done by Taylor series, or with --chain by closed forms, and reports one line a motion: leave out \
             --integrator and --sample"
                .to_owned(),
        ));
    }
    Ok(())
}

//! `lindstedt response PROBLEM --vary Omega=0.5:1.5`.

use std::path::Path;

use crate::coupled::CoupledEquations;
use crate::export::{self, json};
use crate::expr::Expr;
use crate::multiple_scales::{
    CoupledSystem, MultipleScalesError, MultipleScalesOptions, SlowMotion,
    derive as derive_slow_equations,
};
use crate::problem::{Order, Problem, ReadingCommand};
use crate::response::{
    Equations, EquationsError, MOST_HARMONICS, ResponseError, ResponseRequest, respond,
};
use crate::solution::{Method, Solution};
use crate::{Options, Oscillator, Supervision, Symbol, report, solve};
use clap::Args;

use super::answer::{Answer, no_such};
use super::derive::{exact_values, formula, refused as refused_term};
use super::problem::{coupled_equations, expression, problem};
use super::progress::with_progress;
use super::session;
use super::walls::{ContactArguments, EventArguments, WallArguments};
use super::{Common, Failure, Format, Outcome, Work, files, json_text, tolerance, values_of};

/// Steady states of driven, self-excited or free oscillators, of one coordinate or coupled: every
/// branch with its stability, folds, period doublings, backbone
#[derive(Args)]
pub struct ResponseArguments {
    /// An equation in quotes, several separated by `;`, a TOML file, a name of the catalogue, or -
    /// for standard input
    pub problem: String,
    /// The parameter that varies, and from where to where: Omega=0.5:1.5
    #[arg(long, value_name = "NAME=FROM:TO", allow_hyphen_values = true)]
    vary: Option<String>,
    /// A second parameter, and from where to where: bifurcations are followed in both, and stable
    /// motions counted
    #[arg(long, value_name = "NAME=FROM:TO", allow_hyphen_values = true)]
    along: Option<String>,
    /// The quantity that is listed and drawn: a coordinate, or an expression in them such as x - y;
    /// the first coordinate without it
    #[arg(long, value_name = "QUANTITY", allow_hyphen_values = true)]
    of: Option<String>,
    /// harmonic-balance; or multiple-scales or averaging, their steady motions beside the branches
    /// of harmonic balance, which judge them
    #[arg(long)]
    method: Option<String>,
    /// The highest harmonic kept; without it as many as bring the error below a tenth of the
    /// tolerance, 64 at most; of multiple-scales its order
    #[arg(long, value_name = "H", value_parser = super::count, allow_hyphen_values = true)]
    order: Option<u32>,
    /// Periods of the drive in a period of the motion: 2 for motions after a period doubling, 3 for
    /// a third of the frequency
    #[arg(long, value_name = "N", value_parser = super::count, allow_hyphen_values = true)]
    periods: Option<u32>,
    /// The value of another parameter, exact (1.5, 3/2, pi/3); repeatable
    #[arg(long, value_name = "NAME=VALUE,...")]
    at: Vec<String>,
    #[command(flatten)]
    walls: WallArguments,
    #[command(flatten)]
    events: EventArguments,
    #[command(flatten)]
    contacts: ContactArguments,
    #[command(flatten)]
    pub common: Common,
}

impl Work for ResponseArguments {
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

fn run(arguments: &ResponseArguments) -> Result<Outcome, Failure> {
    let problem = arguments.contacts.on(problem(&arguments.problem)?)?;
    let equations = equations(&problem)?;
    let method = method(arguments.method.as_deref().or(problem.method.as_deref()))?;
    if method == Method::Averaging && equations.oscillator().is_none() {
        return Err(Failure::Usage(format!(
            "--method {}: of coupled equations the slow equations are those of --method {}",
            method.name(),
            Method::MultipleScales.name()
        )));
    }
    let is_coupled = equations.oscillator().is_none();
    let walls = arguments.walls.walls(&problem)?;
    let events = arguments.events.events(&problem, &equations.states())?;
    let option = match (walls.is_empty(), events.is_empty()) {
        (true, true) => None,
        (false, _) => Some("--wall"),
        (true, false) => Some("--event"),
    };
    if let Some(option) = option
        && method != Method::HarmonicBalance
    {
        return Err(Failure::Usage(format!(
            "{option}: motions with impacts or events are followed by shooting: leave out --method"
        )));
    }
    if problem.resonance.is_some() && !(is_coupled && method == Method::MultipleScales) {
        return Err(Failure::because(
            "`resonance` belongs to --method multiple-scales of coupled equations: leave it out, or use `lindstedt derive`"
                .to_owned(),
        ));
    }
    let order = match (arguments.order, problem.order) {
        (Some(order), _) | (None, Some(Order::Power(order))) => Some(order),
        (None, None) => None,
        (None, Some(Order::Degrees(_))) => {
            return Err(Failure::because(format!(
                "the order of a response is a number of harmonics, 1 to {MOST_HARMONICS}, or that of the slow equations"
            )));
        }
    };
    let Some(vary) = arguments.vary.as_deref().or(problem.vary.as_deref()) else {
        let name = match &equations {
            Equations::Coupled(coupled) if is_free(coupled) => "omega",
            _ => equations.parameters().first().map_or("Omega", |name| name.name()),
        };
        return Err(Failure::because(format!(
            "nothing varies\n  help: --vary {name}=FROM:TO, or vary = \"{name}=FROM:TO\" in the file"
        )));
    };
    let (parameter, range) = self::range("--vary", vary)?;
    let along = arguments.along.as_deref().or(problem.along.as_deref());
    let of = arguments.of.as_deref().or(problem.of.as_deref());
    // A parameter that the command line varies has no value of the file.
    let of_file = match arguments.vary {
        Some(_) => problem.values_of_motion().map(|values| values.split(&[parameter]).1),
        None => problem.values_of_motion(),
    };
    let values = exact_values(&arguments.at, of_file)?.unwrap_or_default();
    let Supervision { interrupt, progress } = session::supervision();
    let mut question = ResponseRequest {
        of: of.map(|text| quantity(text, &equations)).transpose()?.flatten(),
        along: None,
        equations,
        walls,
        events,
        values,
        parameter,
        range,
        // Slow equations are held against as many harmonics as it takes.
        harmonics: order.filter(|_| method == Method::HarmonicBalance).map(|count| count as usize),
        periods: arguments.periods.or(problem.periods).unwrap_or(1) as usize,
        tolerance: tolerance(&arguments.common),
        interrupt,
        progress,
    };
    question.along =
        along.map(|text| second_parameter(text, parameter, &question.parameters())).transpose()?;
    let mut coupled = None;
    let slow = match (method, question.equations.oscillator()) {
        (Method::HarmonicBalance, _) => None,
        (_, None) => {
            let slow = slow_motion(&question, order, problem.resonance.as_deref())?;
            question.periods = slow.periods.unwrap_or(question.periods);
            coupled = Some(slow);
            None
        }
        (method, Some(oscillator)) => {
            let asked = arguments.periods.or(problem.periods);
            let solution = slow_equations(oscillator, method, order, asked)?;
            // Slow equations relative to a base that moves are held against motions in that
            // coordinate.
            if solution.coordinate() != oscillator.coordinate {
                let moved = Oscillator::from_equation(&solution.equation)
                    .map_err(|error| Failure::with_advice(&error, error.help()))?;
                question.equations = Equations::One(moved);
            }
            question.periods = periods_of(&solution).unwrap_or(question.periods);
            Some(solution)
        }
    };
    let mut response = with_progress("of this search, or of its points", || respond(&question))
        .map_err(refused)?;
    if let Some(solution) = slow {
        response = response.with_slow_equations(solution);
    }
    if let Some(slow) = coupled {
        response = with_progress("of this comparison", || response.with_slow_motion(slow))
            .map_err(|name| Failure::because(format!("no value of {name}")))?;
    }
    let answer = Answer {
        document: &report::response(&response),
        width: files::width(arguments.common.output.as_deref()),
        picture: Some(&|| Ok(export::response::picture(&response)?)),
        other: &|format| match format {
            Format::Csv => Ok(export::response::csv(&response)),
            Format::Json => json_text(&json::response(&response)),
            format => no_such(format),
        },
    };
    Ok(Outcome {
        note: (!response.complete).then(|| {
            format!(
                "warning: stopped early, what there is is kept: {} branches",
                response.branches.len()
            )
        }),
        verdict: Some(response.slow.as_ref().map_or(response.verdict, |slow| slow.verdict)),
        partial: !response.complete,
        ..answer.outcome(&arguments.common)?
    })
}

/// The equations of a problem.
fn equations(problem: &Problem) -> Result<Equations, Failure> {
    if let Some(equations) = coupled_equations(problem, ReadingCommand::Response)? {
        return Ok(Equations::Coupled(equations));
    }
    let formula = formula(problem, ReadingCommand::Response)?;
    Equations::parse(formula.equation).map_err(|error| match error {
        EquationsError::One(error) => Failure::with_advice(&error, error.help()),
        EquationsError::Coupled(error) => Failure::refused(&error, error.help()),
    })
}

/// Whether nothing drives or damps the motion: time does not occur, and a motion backward in time is
/// a motion.
fn is_free(equations: &CoupledEquations) -> bool {
    let count = equations.coordinates.len();
    let (states, right) = (&equations.rates.states, &equations.rates.right);
    let backward = states[count..].iter().map(|name| (*name, -Expr::from(*name))).collect();
    let is_even = |rate: &Expr| {
        let backward = rate.substitute_all(&backward).ok()?;
        (&backward - rate).expand().ok().map(|odd| odd.is_zero())
    };
    states.len() == 2 * count
        && right[count..]
            .iter()
            .all(|rate| !rate.contains(Symbol::new("t")) && is_even(rate) == Some(true))
}

/// The second parameter with its range: a parameter of the equations beside the one that varies.
fn second_parameter(
    text: &str,
    parameter: Symbol,
    known: &[Symbol],
) -> Result<(Symbol, [f64; 2]), Failure> {
    let (name, [low, high]) = range("--along", text)?;
    let usage = |message: String| Err(Failure::Usage(format!("--along {text}: {message}")));
    if name == parameter {
        return usage(format!("{name} varies already"));
    }
    if !known.contains(&name) {
        let others: Vec<&str> =
            known.iter().filter(|other| **other != parameter).map(|other| other.name()).collect();
        return usage(match others.is_empty() {
            true => format!("there is no parameter {name}, and no other one beside {parameter}"),
            false => format!("there is no parameter {name}: choose one of {}", others.join(", ")),
        });
    }
    if !(low < high && (high - low).is_finite()) {
        return Err(refused(ResponseError::Range(name)));
    }
    Ok((name, [low, high]))
}

/// The quantity that is to be listed; `None` for that of one coordinate, which is the coordinate.
fn quantity(text: &str, equations: &Equations) -> Result<Option<Expr>, Failure> {
    let usage = |message: String| Failure::Usage(format!("--of {text}: {message}"));
    let quantity = expression(text).map_err(|error| usage(error.to_string()))?;
    match equations.oscillator() {
        None => Ok(Some(quantity)),
        Some(oscillator) if quantity == Expr::from(oscillator.coordinate) => Ok(None),
        Some(oscillator) => {
            let x = oscillator.coordinate;
            Err(usage(format!("the equation has the coordinate {x} alone, which is listed")))
        }
    }
}

/// Parses the name of a method for steady states.
fn method(name: Option<&str>) -> Result<Method, Failure> {
    let (balance, scales) = (Method::HarmonicBalance, Method::MultipleScales);
    let Some(name) = name else { return Ok(balance) };
    match Method::from_name(name) {
        Some(method) if [balance, scales, Method::Averaging].contains(&method) => Ok(method),
        _ => Err(Failure::Usage(format!(
            "--method {name}: steady states are found by {}, {} or {}",
            balance.name(),
            scales.name(),
            Method::Averaging.name()
        ))),
    }
}

/// The slow equations of the resonance whose motions take this number of drive periods. Where none
/// is asked for it is the primary resonance, or, without a force, the likeliest one, such as the
/// principal parametric resonance with motions of two drive periods.
fn slow_equations(
    oscillator: &Oscillator,
    method: Method,
    order: Option<u32>,
    periods: Option<u32>,
) -> Result<Solution, Failure> {
    if !oscillator.force.contains(Symbol::new("t")) {
        return Err(Failure::Usage(format!(
            "--method {0}: there is no drive; `lindstedt derive --method {0}` has the limit cycle, and harmonic balance its branches",
            method.name()
        )));
    }
    let at = |resonance: Option<(u32, u32)>| {
        let options = Options { method: Some(method), order, resonance, ..Options::default() };
        solve(oscillator, &options)
    };
    // Without a force a motion of the drive's own period is at rest.
    let own = [oscillator.coordinate, oscillator.velocity()];
    let at_rest = oscillator.force.substitute_all(&own.map(|name| (name, Expr::zero())).into());
    let is_forced = at_rest.is_ok_and(|force| force.contains(Symbol::new("t")));
    let likeliest = match periods.is_none() && !is_forced {
        true => at(None).ok().filter(|found| periods_of(found).is_some()),
        false => None,
    };
    likeliest
        .map_or_else(|| at(Some((periods.unwrap_or(1), 1))), Ok)
        .map_err(|refusal| refused_term(oscillator, &refusal))
}

/// The slow equations of coupled equations at the resonance of a drive that is near in the range,
/// sought from its middle outwards.
fn slow_motion(
    question: &ResponseRequest,
    order: Option<u32>,
    resonance: Option<&str>,
) -> Result<SlowMotion, Failure> {
    /// The places in the range, as parts of it.
    const PLACES: [f64; 9] = [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9];
    let refused =
        |error: MultipleScalesError| Failure::refused(&error, error.help()).of_kind(&error);
    let Equations::Coupled(equations) = &question.equations else {
        return Err(Failure::because(
            "slow equations of several coordinates are of several".to_owned(),
        ));
    };
    let system = CoupledSystem::new(equations.clone(), None).map_err(refused)?;
    let [low, high] = question.range;
    let mut last = None;
    for part in PLACES {
        let mut values = question.values.numbers();
        values.insert(question.parameter, low + part * (high - low));
        let options = MultipleScalesOptions {
            order: order.map(|order| order as usize),
            resonance: resonance.map(str::to_owned),
            values,
            ..MultipleScalesOptions::default()
        };
        match derive_slow_equations(&system, &options) {
            Ok(slow) if slow.is_driven() => return Ok(slow),
            Ok(_) => {}
            Err(error) => last = Some(error),
        }
    }
    Err(match last {
        Some(error) => refused(error),
        None => Failure::because(
            "no value in the range is near a resonance at which a drive fixes the phases of the modes that it moves: `lindstedt derive --method multiple-scales --resonance ...` has the slow equations of others"
                .to_owned(),
        ),
    })
}

/// The number of drive periods in a period of the motion of these slow equations; `None` if its
/// amplitude is not that of the first harmonic.
fn periods_of(solution: &Solution) -> Option<usize> {
    let resonance = solution.modulation.as_ref()?.resonance.as_ref()?;
    (resonance.times_driving == 1).then_some(resonance.times_linear as usize)
}

/// A name and a range, the value of an option: `Omega=0.5:1.5`.
pub(super) fn range(option: &str, text: &str) -> Result<(Symbol, [f64; 2]), Failure> {
    let name = text.split(['=', ':']).next().map(str::trim).filter(|name| !name.is_empty());
    let form = || {
        let name = name.unwrap_or("Omega");
        Failure::Usage(format!("{option} {text}: expected NAME=FROM:TO, such as {name}=0.5:1.5"))
    };
    let (name, range) = text.split_once('=').ok_or_else(form)?;
    let (from, to) = range.split_once(':').ok_or_else(form)?;
    let name = expression(name).ok().and_then(|name| name.as_symbol()).ok_or_else(form)?;
    let number = |text: &str| {
        let value = expression(text)
            .map_err(|error| Failure::Usage(format!("{option} {text}: {error}")))?;
        value.evaluate(&Default::default()).map_err(|_| form())
    };
    Ok((name, [number(from)?, number(to)?]))
}

fn refused(error: ResponseError) -> Failure {
    let help = match &error {
        ResponseError::NoDrive => Some(
            "add a force that depends on time, such as - F*cos(Omega*t), or what excites the motion, such as - mu*(1 - x^2)*x'".to_owned(),
        ),
        ResponseError::NoCycle { parameter, .. } => Some(format!(
            "it dies out, escapes, or its cycles lie elsewhere: try another range of {parameter}, or follow it: `lindstedt simulate`"
        )),
        ResponseError::NoPeriods(_) => Some("leave out --periods: the period of a self-excited motion is found".to_owned()),
        ResponseError::NotPeriodic(_) => {
            Some("time may stand inside sin, cos and tan alone, as cos(Omega*t + phi)".to_owned())
        }
        ResponseError::Jump(_) => Some(
            "put (2/pi)*atan(100*x') in place of sgn(x'), or look at the motion itself: `lindstedt simulate` with --every".to_owned(),
        ),
        ResponseError::TwoFrequencies(_) => {
            Some("choose frequencies in the ratio of whole numbers, such as Omega and 2*Omega".to_owned())
        }
        ResponseError::FarFrequencies { .. } => Some(
            "choose a ratio of small whole numbers, such as 11/8 for 1.37, or follow the motion: `lindstedt simulate`".to_owned(),
        ),
        ResponseError::Missing(names) => {
            Some(format!("add {}", values_of(names)))
        }
        ResponseError::NoParameter { known, .. } => known.first().map(|name| format!("--vary {name}=FROM:TO")),
        ResponseError::CountsAndActs { state, .. } => Some(format!(
            "a mode has finitely many values, such as {state} = 1 - {state}; a number of events stands in no force and no condition"
        )),
        ResponseError::OnlyCounts { .. } => Some("vary a parameter of a force, a condition or another state".to_owned()),
        ResponseError::Given(name) => Some(format!("leave out its value, or vary another parameter than {name}")),
        ResponseError::Frequency { parameter, .. } => {
            Some(format!("--vary {parameter} over positive frequencies alone"))
        }
        ResponseError::NotFollowed { parameter, .. } => Some(format!(
            "the steps are parts of the range: try a shorter one, or one that does not begin at zero, --vary {parameter}=FROM:TO"
        )),
        ResponseError::FreeParameter(name) => Some(match name.name() {
            "omega" => "give this parameter another name than omega, and a value: --vary omega=FROM:TO then gives the nonlinear normal modes by their frequency",
            _ => "--vary omega=FROM:TO gives the nonlinear normal modes by their frequency, or add damping or a drive",
        }.to_owned()),
        ResponseError::CoupledJump(_) => Some(
            "make one of them smooth: (2/pi)*atan(100*x') for sgn(x')".to_owned(),
        ),
        ResponseError::WallsWithoutLoss => Some(
            "`lindstedt simulate` with --wall follows one of them; with a drive, damping or a smaller --restitution there are branches".to_owned(),
        ),
        ResponseError::RestsOnWall(_) | ResponseError::RestsOnTwoWalls(..) => Some(
            "`lindstedt simulate` with --wall follows it; a larger coefficient of restitution or a stronger drive keeps it moving"
                .to_owned(),
        ),
        ResponseError::EventsAccumulate => Some(
            "`lindstedt simulate` with --event follows such a motion; events that bounce belong to a wall: --wall and --restitution"
                .to_owned(),
        ),
        ResponseError::NothingMoves { .. } => Some("a stronger drive overcomes it".to_owned()),
        ResponseError::Chatters(argument) => Some(format!(
            "a force that jumps where it holds a place has no next event: write tanh(100*({argument})) for the sign of this, or a stiff spring"
        )),
        ResponseError::UndeterminedFriction(argument) => Some(format!(
            "make this friction smooth: (2/pi)*atan(100*({argument})) for its sign"
        )),
        ResponseError::NotShown { known, .. } => Some(format!(
            "--of takes a coordinate, or an expression in them{}",
            match known.as_slice() {
                [first, second, ..] => format!(", such as {first} - {second}"),
                _ => String::new(),
            }
        )),
        ResponseError::NoModes { .. } => Some(
            "--vary omega from or to beside one of them; where the forces are linear the frequency does not change with the amplitude".to_owned(),
        ),
        ResponseError::NoMotion { undamped: true, .. } => Some("add damping, such as 2*zeta*x'".to_owned()),
        ResponseError::NoMotion { repeats: Some(periods @ 2..), .. } => {
            Some(format!("--periods {periods} asks for them"))
        }
        ResponseError::NoMotion { repeats: Some(_), .. } => Some(
            "motions there are not apart from each other, as where coordinates can be shifted together without a force: a weak spring, such as k*x with --at k=1e-3, holds them"
                .to_owned(),
        ),
        ResponseError::NoMotion { .. } => {
            Some("the motion escapes, never repeats itself, or swings too often in a period of the drive: try another range".to_owned())
        }
        _ => None,
    };
    match error {
        ResponseError::Unknown(_) | ResponseError::Count { .. } => {
            Failure::Usage(error.to_string())
        }
        _ => Failure::refused(&error, help),
    }
}

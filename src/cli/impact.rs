//! `lindstedt impact [FILE]`.

use std::path::PathBuf;

use clap::Args;
use lindstedt::export::{json, latex, text};
use lindstedt::impact::{ContactSpeed, Impact, Setup, solve};
use lindstedt::problem::{Barrier, Order, Problem, Reader};

use super::problem::from_file;
use super::{Common, Failure, Format, Outcome, json_text, tolerance, whole};

#[derive(Args, Default)]
pub struct Arguments {
    /// A TOML file, or - for standard input; without it the paper's swing
    pub file: Option<PathBuf>,
    #[command(flatten)]
    pub common: Common,
}

pub fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let problem = match &arguments.file {
        None => Problem::default(),
        Some(path) => from_file(path)?,
    };
    let impact = solve(setup(&problem)?).map_err(|error| Failure::refused(&error, None))?;
    let tolerance = tolerance(&arguments.common);
    let text = match arguments.common.format {
        Format::Text => text::impact(&impact, tolerance),
        Format::Latex => latex::impact(&impact, tolerance),
        Format::Csv => return super::no_table(),
        Format::Json => json_text(&json::impact(&impact, tolerance))?,
    };
    let picture = arguments
        .common
        .plot
        .as_ref()
        .map(|path| (path.clone(), picture(&impact)));
    Ok(Outcome {
        result: whole(text),
        picture,
        note: None,
        verdict: Some(impact.verdict(ContactSpeed::Paper, tolerance)),
        partial: false,
    })
}

/// The default order of the law: equation (12), the first term beyond the linear one.
const ORDER: u32 = 2;

fn setup(problem: &Problem) -> Result<Setup, Failure> {
    let refuse = |message: &str| Err(Failure::Refused(message.to_owned()));
    problem
        .check_keys(Reader::Impact)
        .map_err(|error| Failure::refused(&error, None))?;
    let damping = &problem.damping;
    if damping.zeta != 0.0
        || damping.alpha != 0.0
        || problem
            .contact
            .mu
            .or(problem.contact.lambda)
            .is_some_and(|mu| mu != 0.0)
    {
        return refuse(
            "the three phases in closed form are those of the undamped equation (9): leave out zeta, alpha, mu and lambda, or use `lindstedt simulate`",
        );
    }
    if problem.excitation.beta != 0.0 {
        return refuse(
            "the three phases in closed form are those of the free motion, equation (9): leave out [excitation], or use `lindstedt simulate`",
        );
    }
    if problem.pendulum.start.is_some() || problem.pendulum.speed.is_some() {
        return refuse(
            "the three phases begin at rest at x = -amplitude: leave out `start` and `speed`, or use `lindstedt simulate`",
        );
    }
    let order = match problem.order {
        None => ORDER,
        Some(Order::Power(order)) => order,
        Some(Order::Degrees(_)) => return refuse("the order of the law is one whole number"),
    };
    if problem.equation.is_some() {
        return refuse("the swing of an impact is x'' + sin(x) = 0: leave out `equation`, or use `lindstedt derive`");
    }
    if problem
        .method
        .as_deref()
        .is_some_and(|name| name != "lindstedt-poincare")
    {
        return refuse("the law of the approach is derived by lindstedt-poincare: leave out `method`");
    }
    let amplitude = problem.pendulum.amplitude;
    let barrier = match problem.pendulum.barrier {
        Barrier::Right(position) => position,
        // A left barrier beyond the release is never touched again.
        Barrier::Both([left, right]) if left < -amplitude => right,
        Barrier::Both(_) => {
            return refuse(
                "released from rest at x = -amplitude the pendulum starts behind the left barrier: move it below -amplitude",
            );
        }
    };
    let refused = |error: lindstedt::problem::ProblemError| Failure::refused(&error, error.help());
    let (stiffness, source) = problem.stiffness().map_err(refused)?;
    Ok(Setup {
        amplitude,
        barrier,
        stiffness,
        stiffness_source: source.to_owned(),
        order,
        rule: problem.linearisation().map_err(refused)?,
        integrator_tolerance: problem.run.integrator_tolerance,
        step_limit: problem.run.step_limit,
    })
}

#[cfg(not(feature = "plot"))]
fn picture(_: &Impact) -> Result<String, Failure> {
    super::no_pictures()
}

#[cfg(feature = "plot")]
fn picture(impact: &Impact) -> Result<String, Failure> {
    use lindstedt::decimal::decimal;
    use lindstedt::export::figure::{CurveStyle, ImpactFigure, ImpactMotion, impact_figure};
    use lindstedt::impact::SampledMotion;

    const POINTS: usize = 600;
    let drawn = impact.paths(POINTS);
    let styles = [
        ("Runge-Kutta", CurveStyle::RUNGE_KUTTA),
        ("closed form, paper", CurveStyle::FORMULA),
        ("closed form, energy", CurveStyle::SECOND_FORMULA),
    ];
    let motion = |(path, (label, style))| {
        let SampledMotion { samples, contact }: &SampledMotion = path;
        ImpactMotion {
            label,
            style,
            samples,
            contact,
        }
    };
    let motions: Vec<_> = drawn.iter().zip(styles).map(motion).collect();
    let setup = &impact.setup;
    let caption = format!(
        "Pendulum and elastic barrier: A = {}, x_c = {}, γ = {}; one period from the release.",
        decimal(setup.amplitude),
        decimal(setup.barrier),
        decimal(setup.stiffness)
    );
    let figure = ImpactFigure {
        left_barrier: None,
        right_barrier: Some(setup.barrier),
        motions: &motions,
        caption: &caption,
    };
    impact_figure(&figure).map_err(|error| Failure::refused(&error, None))
}

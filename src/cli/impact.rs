//! `lindstedt impact [FILE]`.

use std::path::PathBuf;

use clap::Args;
use lindstedt::export::{json, latex, text};
use lindstedt::impact::{ContactSpeed, Impact, Setup, solve};
use lindstedt::problem::Problem;

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
    let setup = Setup::try_from(&problem).map_err(|error| Failure::refused(&error, None))?;
    let impact = solve(setup).map_err(|error| Failure::refused(&error, None))?;
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

#[cfg(not(feature = "plot"))]
fn picture(_: &Impact) -> Result<String, Failure> {
    super::no_pictures()
}

#[cfg(feature = "plot")]
fn picture(impact: &Impact) -> Result<String, Failure> {
    use lindstedt::export::decimal;
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

//! `lindstedt materials [FILE]`.

use std::path::{Path, PathBuf};

use crate::export::json::points::MaterialPoint;
use crate::export::json::shard::Shard;
use crate::export::{json, materials};
use crate::impact::{
    Integrator, MaterialQuestion, MaterialsError, Settings, material_motions, study_from_motions,
    study_materials,
};
use crate::problem::Problem;
use crate::report;
use clap::Args;

use super::answer::{Answer, no_such};
use super::files::width;
use super::problem::from_file;
use super::shard::{self, Points, ShardArguments};
use super::{Common, Failure, Format, Outcome, Work, json_text};

/// The same swing against barriers of several materials: contact, rest time, and what is held fixed
#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
pub struct MaterialsArguments {
    /// A TOML file, or - for standard input; without it the paper's design and the materials of its
    /// Table 2; with [primary] the main mass that carries the pendulum is to come to rest
    pub file: Option<PathBuf>,
    /// Only the materials of the file, without those of the paper's Table 2
    #[arg(long)]
    only_own: bool,
    /// Do not integrate: every motion as a chain of closed forms, good to a percent where damping
    /// is light and dry friction alpha no more than 0.02 of the amplitude
    #[arg(long)]
    chain: bool,
    #[command(flatten)]
    shard: ShardArguments,
    #[command(flatten)]
    pub common: Common,
}

impl Work for MaterialsArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn input(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &MaterialsArguments) -> Result<Outcome, Failure> {
    let problem = match &arguments.file {
        None => Problem::default(),
        Some(path) => from_file(path)?,
    };
    let common = &arguments.common;
    if common.tolerance.is_some() {
        return Err(Failure::Usage(
            "--tolerance belongs to a verdict, and a study of materials has none: leave it out"
                .to_owned(),
        ));
    }
    let mut question = problem
        .materials(arguments.only_own)
        .map_err(|error| Failure::refused(&error, error.help()))?;
    question.settings = Settings { interrupt: super::session::interrupt(), ..question.settings };
    if arguments.chain {
        question.integrator = Integrator::Chain;
    }
    let total = question.materials.len();
    if let Some(shard) = arguments.shard.shard {
        return write_shard(shard, common, &question);
    }
    let study = match shard::known::<MaterialPoint>(total)? {
        None => study_materials(question).map_err(refused)?,
        Some(rows) => {
            let read = |(index, row): (usize, &MaterialPoint)| {
                row.read().ok_or_else(|| shard::unreadable(index))
            };
            let motions = rows.iter().enumerate().map(read).collect::<Result<_, _>>()?;
            study_from_motions(question, motions).map_err(refused)?
        }
    };
    let answer = Answer {
        document: &report::materials(&study),
        width: width(common.output.as_deref()),
        picture: Some(&|| Ok(materials::figure::materials(&study)?)),
        other: &|format| match format {
            Format::Csv => Ok(materials::csv(&study)),
            Format::Json => json_text(&json::materials(&study)),
            format => no_such(format),
        },
    };
    let broken = study.rows.iter().find(|row| !row.course.stop.is_complete());
    let note = broken.map(|row| {
        let (name, stop) = (&row.material.name, row.course.stop);
        format!("warning: {name} stopped early, what there is is kept: {stop}")
    });
    Ok(Outcome { note, partial: broken.is_some(), ..answer.outcome(common)? })
}

fn refused(error: MaterialsError) -> Failure {
    let none = error == MaterialsError::NoMaterial;
    let help = none.then(|| "leave out --only-own, or list materials in a file".to_owned());
    Failure::refused(&error, help)
}

/// The lines of the materials of a shard.
fn write_shard(
    shard: Shard,
    common: &Common,
    question: &MaterialQuestion,
) -> Result<Outcome, Failure> {
    if question.materials.is_empty() {
        return Err(refused(MaterialsError::NoMaterial));
    }
    let inputs = |index: usize| {
        let name = question.materials.get(index).map(|material| material.name.clone());
        [("material".to_owned(), name.into())].into_iter().collect()
    };
    let points = Points {
        total: question.materials.len(),
        together: 1,
        bar: "{bar:40} {pos}/{len} materials, {eta} left",
        inputs: &inputs,
    };
    shard::write(shard, common, &points, |indices| {
        let one = |index: &usize| {
            let motions = material_motions(question, *index).map_err(refused)?;
            let is_done = !question.settings.interrupt.is_requested();
            Ok(is_done.then(|| MaterialPoint::from_motions(&motions)))
        };
        indices.iter().map(one).collect()
    })
}

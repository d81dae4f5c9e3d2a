//! A search as comma-separated values: a row for each run, or for each design of a front.

use crate::export::csv::{cell, head, line, quoted};
use crate::optimize::{Finalist, Objective, OptimizationProblem, SearchRun, Study};

/// The table: for one objective the best design of every run as the search evaluated it, for
/// several the front by integration. The first line is a comment with the units; cells without a
/// value are empty.
///
/// ```
/// use lindstedt::optimize::{OptimizationProblem, StudyObserver, optimize};
///
/// let study = optimize(OptimizationProblem { runs: 2, ..OptimizationProblem::default() }, vec![], &StudyObserver::default())?;
/// assert_eq!(lindstedt::export::optimization::csv(&study).lines().count(), 4);
/// # Ok::<(), lindstedt::optimize::OptimizeError>(())
/// ```
pub fn optimization(study: &Study) -> String {
    let question = &study.question;
    let columns = columns(question);
    let mut text = head(&columns);
    let rows: Vec<Vec<String>> = match question.objectives.len() {
        1 => study.runs.iter().map(|run| best_of(run, question)).collect(),
        _ => study.finalists.iter().map(|one| compromise(one, question)).collect(),
    };
    text.extend(rows.into_iter().map(line));
    text
}

/// Name and unit of each column.
fn columns(question: &OptimizationProblem) -> Vec<(String, String)> {
    let column = |name: &str, unit: &str| {
        let unit = if unit.is_empty() { "1" } else { unit };
        (name.to_owned(), unit.to_owned())
    };
    let of = |objective: &Objective| column(objective.name(), objective.unit());
    let mut columns = vec![column("run", "1")];
    columns.extend(question.objectives.iter().map(of));
    let variables = own_variables(question).map(|index| question.variables[index].parameter);
    columns.extend(variables.map(|parameter| column(parameter.name(), parameter.unit())));
    if !question.materials.is_empty() {
        columns.push(column("material", "-"));
    }
    match question.objectives.len() {
        1 => columns.extend([
            column("generations", "1"),
            column("evaluations", "1"),
            column("integrated", "1"),
            column("stop", "-"),
        ]),
        _ => columns.extend(others(question).map(|objective| of(&objective))),
    }
    columns
}

/// The variables that have a column of their own: the mass has none if it is an objective, whose
/// column shows it.
fn own_variables(question: &OptimizationProblem) -> impl Iterator<Item = usize> {
    let is_objective =
        |name: &str| question.objectives.iter().any(|objective| objective.name() == name);
    (0..question.variables.len())
        .filter(move |&index| !is_objective(question.variables[index].parameter.name()))
}

/// The quantities of a design other than the objectives and the variables.
fn others(question: &OptimizationProblem) -> impl Iterator<Item = Objective> {
    let varies = |name: &str| {
        let mut variables = question.variables.iter();
        variables.any(|variable| variable.parameter.name() == name)
    };
    Objective::ALL
        .into_iter()
        .filter(|objective| !question.objectives.contains(objective))
        .filter(move |objective| !varies(objective.name()))
        .filter(|objective| question.main_mass.is_some() || !objective.is_of_main_mass())
}

/// The best design of a run for one objective, and the statistics of the run.
fn best_of(run: &SearchRun, question: &OptimizationProblem) -> Vec<String> {
    let found = run.found.first();
    let mut fields = vec![run.number.to_string(), number(found.map(|found| found.values[0]))];
    fields
        .extend(own_variables(question).map(|index| number(found.map(|found| found.point[index]))));
    if !question.materials.is_empty() {
        let material = found.and_then(|found| question.case_of(&found.point).1);
        fields.push(name_of(material, question));
    }
    fields.extend([
        run.generations.to_string(),
        run.evaluations.to_string(),
        run.integrated.to_string(),
        run.stop.name().to_owned(),
    ]);
    fields
}

/// A design of the front of several objectives.
fn compromise(finalist: &Finalist, question: &OptimizationProblem) -> Vec<String> {
    let design = &finalist.design;
    let mut fields = vec![finalist.run.to_string()];
    fields.extend(finalist.values.iter().map(|value| number(Some(*value))));
    fields.extend(own_variables(question).map(|index| number(Some(design.point[index]))));
    if !question.materials.is_empty() {
        fields.push(name_of(design.material, question));
    }
    fields.extend(others(question).map(|objective| number(objective.value(design))));
    fields
}

fn number(value: Option<f64>) -> String {
    cell(value.filter(|value| value.is_finite()))
}

fn name_of(material: Option<usize>, question: &OptimizationProblem) -> String {
    let material = material.and_then(|number| question.materials.get(number));
    quoted(material.map_or("", |material| &material.name))
}

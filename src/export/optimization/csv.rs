//! A row for each run, or for each design of a front, to go on with.

use std::fmt::Write as _;

use crate::optimize::{Design, Objective, Study};

/// The table: for one objective the best design of every run by closed forms, for several the front by integration. A first line of comment
/// has the units; what has no value is empty.
///
/// ```
/// use lindstedt::optimize::{Question, Watch, optimize};
///
/// let study = optimize(Question { runs: 2, ..Question::default() }, vec![], &Watch::default())?;
/// assert_eq!(lindstedt::export::optimization::csv(&study).lines().count(), 4);
/// # Ok::<(), lindstedt::optimize::OptimizeError>(())
/// ```
pub fn optimization(study: &Study) -> String {
    let question = &study.question;
    let materials = !question.materials.is_empty();
    let unit = |unit: &str| {
        if unit.is_empty() {
            "1".to_owned()
        } else {
            unit.to_owned()
        }
    };
    let objectives = question
        .objectives
        .iter()
        .map(|objective| (objective.name().to_owned(), unit(objective.unit())));
    let variables = question.variables.iter().map(|variable| {
        let parameter = variable.parameter;
        (parameter.name().to_owned(), unit(parameter.unit()))
    });
    let plain = |name: &str, unit: &str| (name.to_owned(), unit.to_owned());
    let mut columns = vec![plain("run", "1")];
    columns.extend(objectives.chain(variables));
    columns.extend(materials.then(|| plain("material", "-")));
    match question.objectives.len() {
        1 => columns.extend([
            plain("generations", "1"),
            plain("evaluations", "1"),
            plain("integrated", "1"),
            plain("stop", "-"),
        ]),
        _ => columns.extend(
            Objective::ALL
                .into_iter()
                .filter(|objective| !question.objectives.contains(objective))
                .filter(|objective| question.main_mass.is_some() || !objective.is_of_main_mass())
                .map(|objective| (objective.name().to_owned(), unit(objective.unit()))),
        ),
    }
    let joined = |of: fn(&(String, String)) -> &String| {
        let fields: Vec<&str> = columns.iter().map(|column| of(column).as_str()).collect();
        fields.join(",")
    };
    let mut text = format!("# {}\n{}\n", joined(|column| &column.1), joined(|column| &column.0));
    let number = |value: Option<f64>| {
        value
            .filter(|value| value.is_finite())
            .map_or(String::new(), |value| value.to_string())
    };
    let name = |material: Option<usize>| {
        let material = material.and_then(|number| question.materials.get(number));
        super::super::materials::quoted(material.map_or("", |material| &material.name))
    };
    let mut row = |fields: Vec<String>| {
        let _ = writeln!(text, "{}", fields.join(","));
    };
    if question.objectives.len() == 1 {
        for run in &study.runs {
            let found = run.found.first();
            let mut fields = vec![run.number.to_string(), number(found.map(|found| found.values[0]))];
            let count = question.variables.len();
            fields.extend((0..count).map(|index| number(found.map(|found| found.point[index]))));
            if materials {
                fields.push(name(found.and_then(|found| question.case_of(&found.point).1)));
            }
            fields.extend([
                run.generations.to_string(),
                run.evaluations.to_string(),
                run.integrated.to_string(),
                run.stop.name().to_owned(),
            ]);
            row(fields);
        }
        return text;
    }
    for finalist in &study.finalists {
        let design: &Design = &finalist.design;
        let mut fields = vec![finalist.run.to_string()];
        fields.extend(finalist.values.iter().map(|value| number(Some(*value))));
        let count = question.variables.len();
        fields.extend(design.point.iter().take(count).map(|value| number(Some(*value))));
        if materials {
            fields.push(name(design.material));
        }
        let others = Objective::ALL
            .into_iter()
            .filter(|objective| !question.objectives.contains(objective))
            .filter(|objective| question.main_mass.is_some() || !objective.is_of_main_mass());
        fields.extend(others.map(|objective| number(objective.value(design))));
        row(fields);
    }
    text
}

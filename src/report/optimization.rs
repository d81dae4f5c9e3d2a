//! A search for the best damper: the problem, the best design compared with the paper's, the spread
//! of the runs, other searches, and the limiting factors; or the front of several objectives. The
//! sentences follow from the numbers.

mod sentences;

pub use sentences::optimization_sentences;

use super::materials::{MAIN_MASS_EQUATION, chosen, in_words, main_mass_note, percent};
use super::{Block, Document, Heading, cell};
use crate::decimal::{decimal, significant};
use crate::genetic::{Coding, Crossover, GeneticOptions, Mutation, Penalty, StallTest};
use crate::impact::{Model, Parameter, REST_FRACTION};
use crate::optimize::{
    EvaluatedDesign, Finalist, FiveNumberSummary, Objective, OptimizationProblem, Sensitivity,
    Study,
};

/// Largest number of rows of a front that are listed; JSON and tables of comma-separated values
/// have all.
const LISTED: usize = 24;

/// Generations whose best value is listed.
const GENERATIONS: [usize; 9] = [0, 1, 2, 5, 10, 20, 50, 100, 200];

/// The document of a search.
///
/// ```
/// use lindstedt::optimize::{OptimizationProblem, StudyObserver, optimize};
///
/// let study = optimize(OptimizationProblem { runs: 1, ..OptimizationProblem::default() }, vec![], &StudyObserver::default())?;
/// let document = lindstedt::report::optimization(&study);
/// assert!(lindstedt::export::text::document(&document, 120).contains("What decides"));
/// # Ok::<(), lindstedt::optimize::OptimizeError>(())
/// ```
pub fn optimization(study: &Study) -> Document<'_> {
    let mut sections = vec![problem_blocks(study)];
    match study.question.objectives.len() {
        1 => {
            sections.push(best_design(study));
            sections.push(agreement(study));
            sections.extend(decision(study));
        }
        _ => sections.push(front(study)),
    }
    sections.push(optimization_sentences(study).into_iter().map(Block::Sentence).collect());
    Document { sections }
}

/// `rest time, s`
fn column(objective: Objective) -> Heading {
    let (text, latex) = match objective {
        Objective::RestTime => ("rest, s", "rest, s"),
        Objective::DimensionlessRestTime => ("rest, 1/omega", "rest, $1/\\omega$"),
        Objective::PeakForce => ("force, N", "force, N"),
        Objective::PeakPressure => ("pressure, Pa", "pressure, Pa"),
        Objective::Mass => ("mass, kg", "mass, kg"),
        Objective::Impacts => ("impacts", "impacts"),
        Objective::PrimaryRestTime => ("main mass, s", "main mass, s"),
    };
    (text, latex).into()
}

/// A value with its unit.
fn with_unit(objective: Objective, value: f64) -> String {
    format!("{} {}", decimal(value), objective.unit()).trim_end().to_owned()
}

/// The name of a variable: `length`, or `material` for the index after the numbers.
fn name_of(study: &Study, index: usize) -> &'static str {
    let variable = study.question.variables.get(index);
    variable.map_or("material", |variable| variable.parameter.name())
}

/// The value of a variable in a design.
fn value_of(study: &Study, design: &EvaluatedDesign, index: usize) -> String {
    match study.question.variables.get(index) {
        Some(variable) => cell(design.case.get(variable.parameter)),
        None => material_of(study, design),
    }
}

fn material_of(study: &Study, design: &EvaluatedDesign) -> String {
    let material = design.material.and_then(|number| study.question.materials.get(number));
    material.map_or("-".to_owned(), |material| material.name.clone())
}

fn problem_blocks(study: &Study) -> Vec<Block<'_>> {
    let question = &study.question;
    let wishes: Vec<&str> =
        question.objectives.iter().map(|objective| objective.meaning()).collect();
    let runs = match question.runs {
        1 => "one run".to_owned(),
        runs => format!("{runs} runs"),
    };
    let search = match question.objectives.len() {
        1 => "a genetic algorithm",
        _ => "NSGA-II",
    };
    let mut blocks = vec![
        Block::Heading(format!("The best damper by {runs} of {search}: the least of")),
        Block::Note(wishes.join("; ")),
    ];
    let Some(best) = study.best() else {
        return blocks;
    };
    blocks.extend(equation(question, best));
    blocks.extend(held_fixed(question));
    blocks.push(Block::Note(format!(
        "followed by {} until t = {}; rest: {} % of the amplitude of the {} swing",
        route(study),
        decimal(question.settings.duration),
        decimal(100.0 * REST_FRACTION),
        if question.main_mass.is_some() { "largest" } else { "first" }
    )));
    if let Some(of) = question.main_mass {
        let hangs = question.case.start == Some(0.0) && question.case.speed == 0.0;
        blocks.push(main_mass_note(&of, hangs));
    }
    for constraint in question.constraints() {
        blocks.push(Block::Note(format!("constraint: {constraint}")));
    }
    blocks.extend(options(study).into_iter().map(Block::Sentence));
    blocks
}

/// The route by which the designs of the search were followed.
fn route(study: &Study) -> &'static str {
    match study.evaluations() {
        (all, integrated) if integrated == all => "integration",
        (_, 0) => "closed forms",
        _ => "closed forms and integration",
    }
}

/// The largest relative error of closed forms for the best designs, which were verified.
fn closed_forms_off(study: &Study) -> f64 {
    let finite = study.finalists.iter().filter(|finalist| finalist.values[0].is_finite());
    let off = finite
        .filter(|finalist| finalist.by_chain[0] != finalist.values[0])
        .map(|finalist| (finalist.by_chain[0] / finalist.values[0] - 1.0).abs());
    off.fold(0.0, f64::max)
}

/// The equation of the best design, and its numbers.
fn equation<'a>(question: &OptimizationProblem, best: &Finalist) -> Vec<Block<'a>> {
    let Model { zeta, alpha, ref left, ref right, .. } = best.design.model;
    let viscous = if zeta == 0.0 { "" } else { " + 2*zeta*x'" };
    let dry = if alpha == 0.0 { "" } else { " + alpha*sgn(x')" };
    let (x, velocity) = match question.motion_of(&best.design.point) {
        Some((_, start)) => (start.x, start.velocity),
        None => (f64::NAN, f64::NAN),
    };
    let mut blocks = vec![];
    let mut carried = "";
    if question.main_mass.is_some() {
        carried = " + y''*cos(x)";
        blocks.push(Block::Note(MAIN_MASS_EQUATION.to_owned()));
    }
    blocks.push(Block::Note(format!(
        "x''{carried}{viscous}{dry} + sin(x) + (gamma + mu*x')*(x - xc)^(3/2)*H(x - xc) = 0, x(0) = {}, x'(0) = {}",
        decimal(x),
        decimal(velocity)
    )));
    let value = |name: &str, value, source| Block::Value { name: name.into(), value, source };
    blocks.extend(left.map(|left| value("xl", left, Some("the left barrier"))));
    blocks.extend(right.map(|right| value("xc", right, None)));
    blocks.push(Block::SiValue {
        name: "g",
        formula: None,
        value: question.case.design.gravity,
        unit: "m/s^2",
        words: "gravity",
    });
    blocks
}

/// The parameters that the search leaves alone.
fn held_fixed<'a>(question: &OptimizationProblem) -> Vec<Block<'a>> {
    let mut blocks = vec![];
    let default = ", by default: the paper prints none";
    let said = |parameter| {
        if question.defaults.contains(&parameter) { default } else { "" }
    };
    let damping = question.case.contact_damping;
    if question.holds_contact_damping() {
        blocks.push(Block::Note(format!(
            "held fixed: {}{}{}",
            in_words(damping),
            question.case.at_speed.map_or(String::new(), |speed| {
                let unit = question.case.speed_unit.name();
                format!(" at the speed {} {unit}", decimal(speed))
            }),
            said(damping.form())
        )));
    }
    if question.case.zeta != 0.0 || question.case.viscous.is_some() {
        let forms = [
            (Parameter::Viscous, question.case.viscous, "N s/m"),
            (Parameter::Zeta, Some(question.case.zeta), ""),
        ];
        let given = match question.case.viscous {
            Some(_) => Parameter::Viscous,
            None => Parameter::Zeta,
        };
        blocks.push(Block::Note(chosen(given, forms) + said(Parameter::Zeta)));
    }
    if question.case.alpha != 0.0 || question.case.torque.is_some() {
        let forms = [
            (Parameter::Torque, question.case.torque, "N m"),
            (Parameter::Alpha, Some(question.case.alpha), ""),
        ];
        let given = match question.case.torque {
            Some(_) => Parameter::Torque,
            None => Parameter::Alpha,
        };
        blocks.push(Block::Note(chosen(given, forms)));
    }
    for (parameter, unit) in [
        (Parameter::Mass, "kg"),
        (Parameter::Radius, "m"),
        (Parameter::Length, "m"),
        (Parameter::Modulus, "Pa"),
    ] {
        let varies = question.variables.iter().any(|variable| variable.parameter == parameter);
        let of_material = parameter == Parameter::Modulus && !question.materials.is_empty();
        if !varies && !of_material {
            let value = cell(question.case.get(parameter));
            blocks.push(Block::Note(format!("held fixed: {} = {value} {unit}", parameter.name())));
        }
    }
    blocks
}

/// The options of the search.
fn options(study: &Study) -> Vec<String> {
    let question = &study.question;
    let GeneticOptions {
        population,
        elite,
        crossover_fraction,
        coding,
        crossover,
        mutation,
        penalty,
        generations,
        stall_generations,
        function_tolerance,
        stall_test,
        budget,
        ..
    } = question.genetic;
    let (evaluations, integrated) = study.evaluations();
    let mut words = vec![];
    if question.objectives.len() == 1 {
        let coding = match coding {
            Coding::Real => "real numbers".to_owned(),
            Coding::Bits(bits) => format!("{bits} bits a number"),
        };
        let crossover = match crossover {
            Crossover::Heuristic(ratio) => {
                format!("heuristic crossover of ratio {} kept feasible", decimal(ratio))
            }
            Crossover::Scattered => "scattered crossover".to_owned(),
            Crossover::OnePoint => "one-point crossover".to_owned(),
        };
        let mutation = match mutation {
            Mutation::AdaptiveFeasible => "adaptive feasible mutation".to_owned(),
            Mutation::BitFlips(rate) => format!("bit flips at {}", decimal(rate)),
        };
        let penalty = match penalty {
            _ if question.constraints().is_empty() => {
                "no constraint beyond the limits, so no penalty"
            }
            Penalty::Death => "death penalty",
            Penalty::FeasibleFirst => "feasible designs first",
            Penalty::AugmentedLagrangian { .. } => "augmented Lagrangian",
        };
        let penalty = match question.genetic.penalty {
            Penalty::AugmentedLagrangian { initial, factor }
                if !question.constraints().is_empty() =>
            {
                format!(
                    "{penalty} of initial penalty {} and factor {}",
                    decimal(initial),
                    decimal(factor)
                )
            }
            _ => penalty.to_owned(),
        };
        words.push(format!(
            "population {population}, {coding}, rank scaling, stochastic uniform selection, elite {elite}, {crossover} for the fraction {} of \
             the others, {mutation} for the rest; {penalty}",
            decimal(crossover_fraction)
        ));
        let test = match stall_test {
            StallTest::Average => "the average change",
            StallTest::Weighted => "the weighted average change",
        };
        words.push(format!(
            "ends where {test} of the best value over {stall_generations} generations is {} or less, after {generations} generations at the \
             latest",
            decimal(function_tolerance)
        ));
    } else {
        words.push(format!(
            "population {population}, real numbers, {generations} generations, simulated binary crossover, polynomial mutation"
        ));
    }
    if let Some(budget) = budget {
        words.push(format!("no more than {budget} evaluations a run"));
    }
    let by_integration = match question.limits.is_empty() && !question.elastic {
        true => format!("{integrated} of them integrated for want of a closed form"),
        false => format!(
            "{integrated} of them integrated for want of a closed form or to see whether they keep the constraints"
        ),
    };
    words.push(format!(
        "seed {}, run i with its i-th stream; {evaluations} designs tried, {by_integration}",
        question.seed
    ));
    words
}

/// The numbers of a design.
fn quantities(study: &Study, design: &EvaluatedDesign) -> Vec<(Heading, String)> {
    let mut rows: Vec<(Heading, String)> = [
        Objective::RestTime,
        Objective::DimensionlessRestTime,
        Objective::Impacts,
        Objective::PeakForce,
        Objective::PeakPressure,
    ]
    .into_iter()
    .map(|objective| (column(objective), cell(objective.value(design))))
    .collect();
    if study.question.main_mass.is_some() {
        let objective = Objective::PrimaryRestTime;
        rows.push((column(objective), cell(objective.value(design))));
    }
    rows.push((("gamma", "$\\gamma$").into(), decimal(design.model.gamma)));
    rows.push((
        ("mu/gamma", "$\\mu/\\gamma$").into(),
        decimal(design.model.mu / design.model.gamma),
    ));
    let restitution = design.hardest.and_then(|contact| contact.restitution);
    rows.push(("restitution".into(), cell(restitution)));
    if let Some(limit) = study.question.yield_limit(design) {
        let pressure = Objective::PeakPressure.value(design);
        rows.push((
            "pressure/(1.6 Y)".into(),
            cell(pressure.map(|pressure| pressure / (crate::impact::FIRST_YIELD * limit))),
        ));
    }
    rows
}

fn best_design(study: &Study) -> Vec<Block<'_>> {
    let Some(best) = study.best() else {
        return vec![];
    };
    let units = |index: usize| {
        let variable = study.question.variables.get(index);
        variable.map_or("", |variable| variable.parameter.unit())
    };
    let mut rows: Vec<Vec<String>> = (0..best.design.point.len())
        .map(|index| {
            let limits = study.question.variables.get(index);
            vec![
                format!("{}, {}", name_of(study, index), units(index))
                    .trim_end_matches(", ")
                    .to_owned(),
                value_of(study, &best.design, index),
                study
                    .default_design
                    .as_ref()
                    .map_or("-".to_owned(), |papers| value_of(study, papers, index)),
                cell(limits.map(|variable| variable.lower)),
                cell(limits.map(|variable| variable.upper)),
            ]
        })
        .collect();
    let papers = study.default_design.as_ref().map(|papers| quantities(study, papers));
    for (index, (name, value)) in quantities(study, &best.design).into_iter().enumerate() {
        let other = papers.as_ref().and_then(|papers| papers.get(index));
        rows.push(vec![
            name.text.to_owned(),
            value,
            other.map_or("-".to_owned(), |(_, value)| value.clone()),
            String::new(),
            String::new(),
        ]);
    }
    let mut blocks =
        vec![
        Block::Heading(
            "The best design, and the paper's Table 5 under the same assumptions, both integrated"
                .to_owned(),
        ),
        Block::table([
                ("", ""),
                ("best", "best"),
                ("Table 5", "Table 5"),
                ("limit from", "limit from"),
                ("to", "to"),
            ], rows),
    ];
    if route(study) != "integration" {
        let judged = match study.finalists.len() {
            1 => "one design was judged again by integration; its closed form is".to_owned(),
            count => format!(
                "the best {count} different designs of the runs were judged again by integration; closed forms are at most"
            ),
        };
        blocks.push(Block::Note(format!("{judged} {} off", percent(closed_forms_off(study)))));
    }
    blocks
}

fn agreement(study: &Study) -> Vec<Block<'_>> {
    let row = |name: &str, evaluations: usize, spread: Option<FiveNumberSummary>| {
        let of = |number: fn(FiveNumberSummary) -> f64| cell(spread.map(number));
        vec![
            name.to_owned(),
            evaluations.to_string(),
            of(|spread| spread.best),
            of(|spread| spread.lower_quartile),
            of(|spread| spread.median),
            of(|spread| spread.upper_quartile),
            of(|spread| spread.worst),
        ]
    };
    let (evaluations, _) = study.evaluations();
    let each = (evaluations as f64 / study.runs.len().max(1) as f64).round() as usize;
    let mut rows = vec![row("genetic algorithm", each, study.spread())];
    rows.extend(
        study.rivals.iter().map(|rival| row(rival.name, rival.evaluations, rival.spread())),
    );
    let found = study.values().len();
    let count = study.runs.len();
    let with_value = match found == count {
        true => format!("{count} runs each"),
        false => format!(
            "{count} runs each; of the genetic algorithm {found} found a design that rests and keeps the constraints"
        ),
    };
    let curve = study.median_curve();
    let shown: Vec<usize> = GENERATIONS
        .into_iter()
        .filter(|generation| generation + 1 < curve.len())
        .chain(curve.len().checked_sub(1))
        .collect();
    let number = |value: f64| {
        if value.is_finite() { significant(value, 7) } else { "-".to_owned() }
    };
    vec![
        Block::Heading(format!(
            "How far the runs agree, and what as many evaluations find otherwise: {}, {}, by {}",
            study.objective().meaning(),
            study.objective().unit(),
            route(study)
        )),
        Block::table(
            [
                ("search", "search"),
                ("evaluations", "evaluations"),
                ("best", "best"),
                ("lower quartile", "lower quartile"),
                ("median", "median"),
                ("upper quartile", "upper quartile"),
                ("worst", "worst"),
            ],
            rows,
        ),
        Block::Note(with_value),
        Block::table(
            [("generation", "generation"), ("best so far, median", "best so far, median")],
            shown
                .into_iter()
                .map(|generation| vec![generation.to_string(), number(curve[generation])]),
        ),
    ]
}

fn decision(study: &Study) -> Option<Vec<Block<'_>>> {
    let decision = study.decision.as_ref()?;
    let row = |sensitivity: &Sensitivity| {
        let [from, to] = sensitivity.alone;
        let range = sensitivity.range;
        vec![
            sensitivity.parameter.name().to_owned(),
            decimal(sensitivity.value),
            sensitivity.elasticity.map_or("-".to_owned(), |slope| significant(slope, 3)),
            significant(from, 4),
            significant(to, 4),
            cell(range.map(|range| range[0])),
            cell(range.map(|range| range[1])),
            sensitivity.role.name().to_owned(),
        ]
    };
    let mut blocks = vec![
        Block::Heading("What decides: every variable alone, the others held at the best design".to_owned()),
        Block::table([
                ("variable", "variable"),
                ("best", "best"),
                ("elasticity", "elasticity"),
                ("as good from", "as good from"),
                ("to", "to"),
                ("least", "least"),
                ("greatest", "greatest"),
                ("role", "role"),
            ], decision.sensitivities.iter().map(row)),
        Block::Note(
            "elasticity: change of the objective in % for 1 % of the variable; as good: no more than 1 % worse"
                .to_owned(),
        ),
        Block::Note(
            "least and greatest: of the objective over the whole range between the limits, constraints aside"
                .to_owned(),
        ),
    ];
    if decision.materials.len() > 1 {
        let rows = study.question.materials.iter().zip(&decision.materials);
        blocks.push(Block::table(
            ["material, the rest as it is best".into(), column(study.objective())],
            rows.map(|(material, value)| vec![material.name.clone(), cell(*value)]),
        ));
    }
    Some(blocks)
}

fn front(study: &Study) -> Vec<Block<'_>> {
    let question = &study.question;
    let mut names: Vec<Heading> = question.objectives.iter().copied().map(column).collect();
    let variables = question.variables.iter().map(|variable| {
        let (text, latex) = match variable.parameter {
            Parameter::Mass => ("m, kg", "$m$, kg"),
            Parameter::Radius => ("R, m", "$R$, m"),
            Parameter::Length => ("L, m", "$L$, m"),
            _ => ("E, Pa", "$E$, Pa"),
        };
        Heading::from((text, latex))
    });
    names.extend(variables);
    let materials = !question.materials.is_empty();
    names.extend(materials.then_some(Heading::from("material")));
    let row = |values: Vec<String>, design: &EvaluatedDesign| {
        let numbers =
            question.variables.iter().map(|variable| cell(design.case.get(variable.parameter)));
        let material = materials.then(|| material_of(study, design));
        values.into_iter().chain(numbers).chain(material).collect::<Vec<String>>()
    };
    let count = study.finalists.len();
    let shown: Vec<usize> = match count > LISTED {
        true => (0..LISTED).map(|place| place * (count - 1) / (LISTED - 1)).collect(),
        false => (0..count).collect(),
    };
    let number = |value: &f64| cell(Some(*value).filter(|value| value.is_finite()));
    let mut blocks = vec![
        Block::Heading(format!(
            "The front: {count} designs none of which is better than another in everything, integrated{}",
            if shown.len() < count { format!(", {} of them", shown.len()) } else { String::new() }
        )),
        Block::table(
            names,
            shown.into_iter().map(|index| {
                let finalist = &study.finalists[index];
                row(finalist.values.iter().map(number).collect(), &finalist.design)
            }),
        ),
    ];
    if let Some(papers) = &study.default_design {
        let values: Vec<String> = question
            .objectives
            .iter()
            .map(|objective| {
                let value = objective
                    .value(papers)
                    .map_or("no value".to_owned(), |value| with_unit(*objective, value));
                format!("{} {value}", objective.meaning())
            })
            .collect();
        blocks.push(Block::Sentence(format!(
            "the paper's Table 5 under the same assumptions: {}",
            values.join(", ")
        )));
    }
    blocks
}

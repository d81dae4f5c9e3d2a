//! The results of a search, in sentences: its limits, and its optimum compared with the paper's
//! design and with other searches.

use super::super::materials::percent;
use super::{closed_forms_off, with_unit};
use crate::decimal::{decimal, significant};
use crate::genetic::GeneticStop;
use crate::impact::Parameter;
use crate::optimize::{DEFAULT_BOX, Decision, Objective, Sensitivity, Study, VariableRole, WITHIN};

/// `mass, radius and modulus`
fn listed(names: &[&str]) -> String {
    match names.split_last() {
        Some((last, [])) => (*last).to_owned(),
        Some((last, names)) => format!("{} and {last}", names.join(", ")),
        None => String::new(),
    }
}

/// The results of a search, in sentences.
pub fn optimization_sentences(study: &Study) -> Vec<String> {
    let mut sentences = Vec::new();
    if !study.complete {
        let (done, all) = (study.runs.len(), study.question.runs);
        let cut_short =
            study.runs.iter().filter(|run| run.stop == GeneticStop::Interrupted).count();
        let of_these = match cut_short {
            0 => String::new(),
            number => format!(", {number} of them cut short"),
        };
        sentences.push(match done < all || cut_short > 0 {
            true => format!(
                "Stopped before the end: {done} of {all} runs are in this result{of_these}, and what was left is missing."
            ),
            false => format!(
                "Stopped before the end: all {all} runs are in this result, the comparison with other searches is missing."
            ),
        });
    }
    match study.question.objectives.len() {
        1 => {
            sentences.extend(what_decides(study));
            sentences.extend(the_unit(study));
            sentences.extend(the_papers(study));
            sentences.extend(the_rivals(study));
            sentences.extend(the_generations(study));
        }
        _ => sentences.extend(the_front(study)),
    }
    sentences
}

/// The relative difference of a value to a reference; `None` if only the reference is zero.
fn apart(value: f64, reference: f64) -> Option<f64> {
    let apart = match value == reference {
        true => 0.0,
        false => value / reference - 1.0,
    };
    Some(apart).filter(|apart| apart.is_finite())
}

/// Relative improvement by another search from which on the best design of this one counts as no
/// optimum.
const BETTER: f64 = 1e-3;

/// The search that found a better design than the best one of the study, and the relative
/// improvement; `None` if there is none.
fn found_better(study: &Study, decision: &Decision) -> Option<(String, f64)> {
    let own = study.spread()?.best;
    let rivals = study.rivals.iter();
    let rivals = rivals
        .filter_map(|rival| Some((rival.name.to_owned(), -apart(rival.spread()?.best, own)?)));
    let alone =
        apart(decision.least, decision.value).map(|apart| ("a look around it".to_owned(), -apart));
    let best = rivals.chain(alone).max_by(|one, other| one.1.total_cmp(&other.1));
    // Differences within the error of the closed forms decide nothing.
    best.filter(|(_, better)| *better > BETTER.max(closed_forms_off(study)))
}

fn what_decides(study: &Study) -> Vec<String> {
    let Some(decision) = &study.decision else {
        return vec![];
    };
    let objective = study.objective().meaning();
    let of = |role: VariableRole| {
        let found =
            decision.sensitivities.iter().filter(move |sensitivity| sensitivity.role == role);
        found.collect::<Vec<_>>()
    };
    let names = |found: &[&Sensitivity]| {
        let names: Vec<&str> =
            found.iter().map(|sensitivity| sensitivity.parameter.name()).collect();
        listed(&names)
    };
    let mut sentences = Vec::new();
    let better = found_better(study, decision);
    if let Some((name, better)) = &better {
        sentences.push(format!(
            "The best design here is no optimum: {name} found one that is {} better. Give the search a larger population and more generations; \
             what follows is said of the design that was found.",
            percent(*better)
        ));
    }
    let off = closed_forms_off(study);
    if off > WITHIN {
        sentences.push(format!(
            "Closed forms are up to {} off for the best designs: what follows is said by closed forms, and by integration it may be otherwise.",
            percent(off)
        ));
    }
    let ends: Vec<String> =
        [(of(VariableRole::Lower), "lower"), (of(VariableRole::Upper), "upper")]
            .into_iter()
            .filter(|(found, _)| !found.is_empty())
            .map(|(found, end)| format!("{} at the {end} limit", names(&found)))
            .collect();
    if !ends.is_empty() {
        sentences.push(match better {
            None if off <= WITHIN => format!(
                "The optimum is a corner of the box, {}: the limit decides, not the search, and moving it moves the optimum.",
                ends.join(", ")
            ),
            _ => format!("Moved alone, the best are {}.", ends.join(", ")),
        });
    }
    let flat = of(VariableRole::Flat);
    if !flat.is_empty() {
        sentences.push(flat_directions(&flat, objective));
    }
    let is_worse_everywhere = |sensitivity: &&Sensitivity| {
        let least = sensitivity.range.map_or(f64::INFINITY, |[least, _]| least);
        least >= decision.value * (1.0 - BETTER)
    };
    let (trade, elsewhere): (Vec<_>, Vec<_>) =
        of(VariableRole::Trade).into_iter().partition(is_worse_everywhere);
    if !trade.is_empty() {
        sentences.push(format!(
            "A trade: {} between the limits, {objective} is worse on either side.",
            names(&trade)
        ));
    }
    if !elsewhere.is_empty() {
        sentences.push(format!(
            "Nearby {objective} is worse on either side of {}, and further away, constraints aside, it is less.",
            names(&elsewhere)
        ));
    }
    // Whether a design that the constraint forbids would be better.
    let relieved = |sensitivity: &&Sensitivity| {
        sensitivity
            .range
            .is_some_and(|[least, _]| least < decision.least.min(decision.value) * (1.0 - BETTER))
    };
    let (relieved, held): (Vec<_>, Vec<_>) =
        of(VariableRole::Limit).into_iter().partition(relieved);
    if !relieved.is_empty() {
        sentences.push(format!(
            "A constraint stops {}: without it {objective} would be less.",
            names(&relieved)
        ));
    }
    if !held.is_empty() {
        sentences.push(format!("A constraint stops {}.", names(&held)));
    }
    if !decision.active.is_empty() {
        sentences.push(format!(
            "Constraints with no more than 1 % to spare: {}.",
            decision.active.join("; ")
        ));
    }
    sentences.push(near_the_best(study, decision));
    sentences
}

fn flat_directions(flat: &[&Sensitivity], objective: &str) -> String {
    let changes: Vec<String> = flat
        .iter()
        .map(|sensitivity| match sensitivity.range {
            Some([least, greatest]) => {
                format!("{} {}", sensitivity.parameter.name(), percent((greatest - least) / least))
            }
            None => sensitivity.parameter.name().to_owned(),
        })
        .collect();
    let free = flat.iter().all(|sensitivity| sensitivity.alone == sensitivity.limits);
    let but = if free { "" } else { " but where constraints end" };
    let names: Vec<&str> = flat.iter().map(|sensitivity| sensitivity.parameter.name()).collect();
    format!(
        "Flat directions: over the whole range, the others held, {objective} changes by no more than 1 % ({}); what was found for {} says \
         nothing{but}.",
        changes.join(", "),
        listed(&names)
    )
}

fn near_the_best(study: &Study, decision: &Decision) -> String {
    if decision.share == 0.0 {
        return format!(
            "None of {} designs that were drawn from the box and from what is as good alone is within {} % of the best.",
            decision.drawn,
            decimal(100.0 * WITHIN)
        );
    }
    let extents: Vec<String> = study
        .question
        .variables
        .iter()
        .zip(&decision.extents)
        .map(|(variable, [from, to])| {
            format!(
                "{} {} to {} {}",
                variable.parameter.name(),
                significant(*from, 3),
                significant(*to, 3),
                variable.parameter.unit()
            )
        })
        .collect();
    format!(
        "Designs within {} % of the best are {} of the box; those that were drawn: {}.",
        decimal(100.0 * WITHIN),
        percent(decision.share),
        extents.join(", ")
    )
}

fn the_unit(study: &Study) -> Option<String> {
    let ends = study.decision.as_ref()?.ends?;
    let pair = |[short, long]: [f64; 2]| [significant(short, 4), significant(long, 4)];
    let ([short, long], [from, to], [at, until]) =
        (pair(ends.seconds), pair(ends.dimensionless), pair(ends.lengths));
    let [in_seconds, in_units] = ends.best_lengths.map(|length| significant(length, 3));
    let mut turned = ends.best_lengths;
    turned.sort_by(f64::total_cmp);
    let verdict = match ends.best_lengths {
        [one, other] if one == other => {
            format!("in both the best length, the rest held, is {in_seconds} m")
        }
        _ => format!(
            "the rest held, in seconds the best length is {in_seconds} m, in 1/omega it is {in_units} m: the choice moves the optimum{}",
            if turned == ends.lengths { " from one end to the other" } else { "" }
        ),
    };
    Some(format!(
        "The unit of the rest time: with the length at {at} and {until} m the best design rests after {short} and {long} s, or {from} and {to} \
         in units of 1/omega = sqrt(L/g); {verdict}."
    ))
}

fn the_papers(study: &Study) -> Option<String> {
    let (papers, best) = (study.default_design.as_ref()?, study.best()?);
    let objective = study.objective();
    let Some(value) = objective.value(papers) else {
        return Some(
            "The paper's Table 5 does not rest in the time allowed under these assumptions."
                .to_owned(),
        );
    };
    let least = best.values[0];
    let question = &study.question;
    let outside: Vec<&str> = question
        .variables
        .iter()
        .zip(&papers.point)
        .filter(|(variable, value)| !(variable.lower..=variable.upper).contains(value))
        .map(|(variable, _)| variable.parameter.name())
        .collect();
    let other: Vec<&str> = DEFAULT_BOX
        .iter()
        .map(|(parameter, ..)| *parameter)
        .filter(|parameter| {
            question.variables.iter().all(|variable| variable.parameter != *parameter)
        })
        .filter(|parameter| question.case.get(*parameter) != papers.case.get(*parameter))
        .map(Parameter::name)
        .collect();
    let broken = question.broken(papers);
    let mut remarks = String::new();
    if !outside.is_empty() {
        remarks += &format!(" It lies outside these limits: {}.", listed(&outside));
    }
    if !other.is_empty() {
        remarks += &format!(" It differs in what is held fixed here: {}.", listed(&other));
    }
    if !broken.is_empty() {
        remarks += &format!(" It breaks {}.", broken.join("; "));
    }
    let far = apart(value, least);
    let allowed = remarks.is_empty();
    let judged = match far {
        Some(far) if far < -BETTER && allowed => "better than any design that the search found",
        Some(far) if far < 0.0 && !allowed => "better than any design found that is allowed here",
        Some(far) if far <= WITHIN && allowed => "as good as the best",
        Some(far) if far <= WITHIN => "no more than 1 % worse than the best that is allowed here",
        _ => "not the best under these assumptions, which the paper does not print",
    };
    let compared = match far {
        Some(0.0) => "the same as".to_owned(),
        Some(far) => {
            format!("{} {} than", percent(far.abs()), if far < 0.0 { "less" } else { "more" })
        }
        None => "more than".to_owned(),
    };
    Some(format!(
        "The paper's Table 5 has {} {}, {compared} the best design's {}: {judged}.{remarks}",
        objective.meaning(),
        with_unit(objective, value),
        with_unit(objective, least)
    ))
}

fn the_rivals(study: &Study) -> Option<String> {
    let own = study.spread()?.median;
    let runs = study.runs.len();
    let of_runs = |found: usize| match found == runs {
        true => String::new(),
        false => format!(" in the {found} of {runs} runs that found one"),
    };
    let said: Vec<String> = study
        .rivals
        .iter()
        .map(|rival| {
            let found = rival.values.iter().filter(|value| value.is_finite()).count();
            let Some(spread) = rival.spread() else {
                return format!("{} finds no design", rival.name);
            };
            let words = match apart(spread.median, own) {
                Some(apart) if apart.abs() < 5e-7 => "the same".to_owned(),
                Some(apart) => format!(
                    "{} {}",
                    percent(apart.abs()),
                    if apart > 0.0 { "worse" } else { "better" }
                ),
                None => with_unit(study.objective(), spread.median) + " instead of 0",
            };
            format!("{} finds {words}{}", rival.name, of_runs(found))
        })
        .collect();
    match said.is_empty() {
        true => None,
        false => Some(format!(
            "What the genetic algorithm is worth: with as many evaluations, in the median{}, {}.",
            of_runs(study.values().len()),
            said.join(", ")
        )),
    }
}

fn the_generations(study: &Study) -> Option<String> {
    let window = study.question.genetic.stall_generations;
    let earliest = window + 1;
    let stalled: Vec<usize> = study
        .runs
        .iter()
        .filter(|run| run.stop == GeneticStop::Stalled)
        .map(|run| run.generations)
        .collect();
    let at_once = stalled.iter().filter(|generations| **generations == earliest).count();
    let settled = study.generation_of_convergence(1e-3)?;
    let when = match settled {
        0 => "already in its random population".to_owned(),
        generation => format!("from generation {generation} on"),
    };
    let count = study.runs.len();
    let end = match (stalled.len(), at_once) {
        (0, _) => "no run ended because the best value stood still".to_owned(),
        (ended, at_once) => format!(
            "{ended} of {count} runs ended because the best value stood still, {at_once} of them after {earliest} generations, the earliest that a \
             window of {window} allows"
        ),
    };
    let either = if count > 0 && at_once == count { " either" } else { "" };
    Some(format!(
        "Convergence: {end}; the median run was within 0.1 % of its end {when}. The paper's 51 generations are the earliest end with the usual \
         window of 50: its best value hardly moved{either}."
    ))
}

fn the_front(study: &Study) -> Vec<String> {
    let extreme = |(index, objective): (usize, &Objective)| {
        let least = study
            .finalists
            .iter()
            .filter(|finalist| finalist.values[index].is_finite())
            .min_by(|one, other| one.values[index].total_cmp(&other.values[index]))?;
        let others: Vec<String> = study
            .question
            .objectives
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != index)
            .map(|(other, objective)| {
                format!("{} {}", objective.meaning(), with_unit(*objective, least.values[other]))
            })
            .collect();
        Some(format!(
            "The least of {} is {}, with {}.",
            objective.meaning(),
            with_unit(*objective, least.values[index]),
            others.join(", ")
        ))
    };
    let mut sentences: Vec<String> =
        study.question.objectives.iter().enumerate().filter_map(extreme).collect();
    if study.finalists.len() == 1 {
        sentences
            .push("Of the designs that were followed one is the best in everything.".to_owned());
    }
    sentences
}

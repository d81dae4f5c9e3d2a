//! What the numbers of a search say, in sentences: what decides, how its optimum compares with the paper's design and with other searches.

use super::super::materials::percent;
use super::with_unit;
use crate::decimal::{decimal, significant};
use crate::genetic::Stop;
use crate::optimize::{Decision, Objective, Role, Sensitivity, Study, WITHIN};

/// `mass, radius and modulus`
fn listed(names: &[&str]) -> String {
    match names.split_last() {
        Some((last, [])) => (*last).to_owned(),
        Some((last, names)) => format!("{} and {last}", names.join(", ")),
        None => String::new(),
    }
}

/// What the numbers of a search say, in sentences.
pub fn optimization_sentences(study: &Study) -> Vec<String> {
    let mut sentences = Vec::new();
    if !study.complete {
        sentences.push(format!(
            "Stopped before the end: {} of {} runs are in this result, and what was left is missing.",
            study.runs.len(),
            study.question.runs
        ));
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

fn what_decides(study: &Study) -> Vec<String> {
    let Some(decision) = &study.decision else {
        return vec![];
    };
    let objective = study.objective().meaning();
    let of = |role: Role| {
        let found = decision
            .sensitivities
            .iter()
            .filter(move |sensitivity| sensitivity.role == role);
        found.collect::<Vec<_>>()
    };
    let names = |found: &[&Sensitivity]| {
        let names: Vec<&str> = found.iter().map(|sensitivity| sensitivity.parameter.name()).collect();
        listed(&names)
    };
    let (lower, upper) = (of(Role::Lower), of(Role::Upper));
    let mut sentences = Vec::new();
    let ends: Vec<String> = [(&lower, "lower"), (&upper, "upper")]
        .into_iter()
        .filter(|(found, _)| !found.is_empty())
        .map(|(found, end)| format!("{} at the {end} limit", names(found)))
        .collect();
    if !ends.is_empty() {
        sentences.push(format!(
            "The optimum is a corner of the box, {}: the limit decides, not the search, and moving it moves the optimum.",
            ends.join(", ")
        ));
    }
    let flat = of(Role::Flat);
    if !flat.is_empty() {
        sentences.push(flat_directions(&flat, objective));
    }
    let trade = of(Role::Trade);
    if !trade.is_empty() {
        sentences.push(format!(
            "A trade: {} between the limits, {objective} is worse on either side.",
            names(&trade)
        ));
    }
    let limited = of(Role::Limit);
    if !limited.is_empty() {
        sentences.push(format!(
            "A constraint stops {}: without it {objective} would be less.",
            names(&limited)
        ));
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
                format!(
                    "{} {}",
                    sensitivity.parameter.name(),
                    percent((greatest - least) / least)
                )
            }
            None => sensitivity.parameter.name().to_owned(),
        })
        .collect();
    let free = flat.iter().all(|sensitivity| sensitivity.alone == sensitivity.limits);
    let but = if free { "" } else { " but where constraints end" };
    let names: Vec<&str> = flat.iter().map(|sensitivity| sensitivity.parameter.name()).collect();
    format!(
        "Flat directions: over the whole range, the others held, {objective} changes by less than 1 % ({}); what was found for {} says \
         nothing{but}.",
        changes.join(", "),
        listed(&names)
    )
}

fn near_the_best(study: &Study, decision: &Decision) -> String {
    let share = match decision.share {
        0.0 => "too small a part of the box to be met by chance".to_owned(),
        share => format!("{} of the box", percent(share)),
    };
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
        "Designs within {} % of the best are {share}: {}.",
        decimal(100.0 * WITHIN),
        extents.join(", ")
    )
}

fn the_unit(study: &Study) -> Option<String> {
    let ends = study.decision.as_ref()?.ends?;
    let pair = |[short, long]: [f64; 2]| [significant(short, 4), significant(long, 4)];
    let ([short, long], [from, to], [at, until]) = (pair(ends.seconds), pair(ends.dimensionless), pair(ends.lengths));
    let best = |[short, long]: [f64; 2]| if short < long { &at } else { &until };
    let same = best(ends.seconds) == best(ends.dimensionless);
    let verdict = match same {
        true => "the unit does not move the optimum".to_owned(),
        false => format!(
            "in seconds the best length is {}, in 1/omega it is {}: the choice moves the optimum from one end to the other",
            best(ends.seconds),
            best(ends.dimensionless)
        ),
    };
    Some(format!(
        "The unit of the rest time: with the length at {at} and {until} m the best design rests after {short} and {long} s, or {from} and {to} \
         in units of 1/omega = sqrt(L/g); {verdict}."
    ))
}

fn the_papers(study: &Study) -> Option<String> {
    let (papers, best) = (study.papers.as_ref()?, study.best()?);
    let objective = study.objective();
    let Some(value) = objective.value(papers) else {
        return Some("The paper's Table 5 does not rest in the time allowed under these assumptions.".to_owned());
    };
    let least = best.values[0];
    let outside: Vec<&str> = study
        .question
        .variables
        .iter()
        .zip(&papers.point)
        .filter(|(variable, value)| !(variable.lower..=variable.upper).contains(value))
        .map(|(variable, _)| variable.parameter.name())
        .collect();
    let place = match outside.is_empty() {
        true => String::new(),
        false => format!(" It lies outside these limits: {}.", listed(&outside)),
    };
    let far = value / least - 1.0;
    let judged = match far <= WITHIN {
        true if far < 0.0 && !outside.is_empty() => "better than any design between the limits",
        true => "as good as the best",
        false => "not the best under these assumptions, which the paper does not print",
    };
    Some(format!(
        "The paper's Table 5 has {} {}, {} {} than the best design's {}: {judged}.{place}",
        objective.meaning(),
        with_unit(objective, value),
        percent(far.abs()),
        if far < 0.0 { "less" } else { "more" },
        with_unit(objective, least)
    ))
}

fn the_rivals(study: &Study) -> Option<String> {
    let own = study.spread()?.median;
    let said: Vec<String> = study
        .rivals
        .iter()
        .filter_map(|rival| {
            let apart = rival.spread()?.median / own - 1.0;
            let words = match apart.abs() < 5e-7 {
                true => "the same".to_owned(),
                false => format!(
                    "{} {}",
                    percent(apart.abs()),
                    if apart > 0.0 { "worse" } else { "better" }
                ),
            };
            Some(format!("{} finds {words}", rival.name))
        })
        .collect();
    match said.is_empty() {
        true => None,
        false => Some(format!(
            "What the genetic algorithm is worth: with as many evaluations, in the median, {}.",
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
        .filter(|run| run.stop == Stop::Stalled)
        .map(|run| run.generations)
        .collect();
    let at_once = stalled.iter().filter(|generations| **generations == earliest).count();
    let settled = study.settled(1e-3)?;
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
    Some(format!(
        "Convergence: {end}; the median run was within 0.1 % of its end {when}. The paper's 51 generations are the earliest end with the usual \
         window of 50: its best value hardly moved either."
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
            .map(|(other, objective)| format!("{} {}", objective.meaning(), with_unit(*objective, least.values[other])))
            .collect();
        Some(format!(
            "The least of {} is {}, with {}.",
            objective.meaning(),
            with_unit(*objective, least.values[index]),
            others.join(", ")
        ))
    };
    let mut sentences: Vec<String> = study
        .question
        .objectives
        .iter()
        .enumerate()
        .filter_map(extreme)
        .collect();
    if study.finalists.len() == 1 {
        sentences.push("One design is the best in everything: these wishes do not conflict.".to_owned());
    }
    sentences
}

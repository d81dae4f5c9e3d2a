//! Steady states of an oscillator: branches with their stability, their bifurcations, and the error
//! against the true motion.

mod coupled;

use std::borrow::Cow;

use super::trajectory::{event_in_words, wall_in_words};
use super::{Block, Document};
use crate::decimal::{decimal, significant};
use crate::derivation::DerivationLine;
use crate::expr::{Expr, Function, Node};
use crate::response::bifurcation::BifurcationKind;
use crate::response::continuation::BranchEnd;
use crate::response::slow::{SlowEquations, SlowResponse};
use crate::response::{
    AperiodicMotion, Branch, Elsewhere, Equations, MOST_HARMONICS, MOST_IMPACTS, ResponseDiagram,
    SteadyMotion,
};
use crate::solution::Solution;
use crate::symbol::Symbol;
use crate::values::Values;

pub(crate) use coupled::{are_modes, has_energy, listed_quantity};

/// Number of rows of the table of a branch.
const ROWS: usize = 13;

/// Largest number of listed bifurcations.
const MOST_BIFURCATIONS: usize = 40;

/// The document of a response.
///
/// ```
/// use lindstedt::response::{ResponseRequest, respond};
///
/// let question = ResponseRequest::new("x'' + x'/5 + x - cos(Omega*t) = 0", "Omega", [0.5, 1.5], "")?;
/// let document = lindstedt::report::response(&respond(&question)?);
/// let text = lindstedt::export::text::document(&document, 120);
/// assert!(text.contains("verdict") && text.contains("branch 1"), "{text}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn response(response: &ResponseDiagram) -> Document<'static> {
    let mut sections = vec![question(response)];
    for (index, branch) in response.branches.iter().enumerate() {
        sections.push(self::branch(response, index, branch));
    }
    sections.extend(coupled::equilibria(response));
    sections.extend(changes(response));
    sections.extend(coupled::two_parameters(response));
    sections.extend(backbone(response));
    sections.push(judgement(response));
    sections.extend(response.slow.as_ref().map(|slow| by_slow_equations(response, slow)));
    Document { sections }
}

fn question(response: &ResponseDiagram) -> Vec<Block<'static>> {
    let asked = &response.question;
    let sides = asked.equations.sides().into_iter();
    let mut blocks: Vec<Block> = sides
        .map(|(left, right)| Block::Line(Cow::Owned(DerivationLine::equation(left, right))))
        .collect();
    blocks.extend(numbers(&asked.values).map(|(name, value)| Block::Value {
        name,
        value,
        source: None,
    }));
    let several = asked.walls.len() > 1;
    let walls = asked.walls.iter().enumerate();
    blocks.extend(walls.map(|(index, wall)| Block::Note(wall_in_words(index, wall, several))));
    let several = asked.events.len() > 1;
    let events = asked.events.iter().enumerate();
    blocks.extend(events.map(|(index, event)| Block::Note(event_in_words(index, event, several))));
    let (name, [low, high]) = (asked.parameter, asked.range);
    if coupled::is_coupled(response) {
        blocks.extend(coupled::question(response));
        return blocks;
    }
    if response.self_excited {
        blocks.extend(self_excited(response));
        return blocks;
    }
    blocks.push(Block::Sentence(format!(
        "{name} from {} to {}; {}, harmonics 0 to {}; theta = {}, and a motion takes {} of the drive.",
        decimal(low),
        decimal(high),
        method(response),
        response.harmonics,
        phase(response),
        periods_in_words(asked.periods)
    )));
    blocks.push(Block::Sentence(format!(
        "amplitude: of the first harmonic, amplitude*cos(theta - phase); peak: half of peak to peak; {}.",
        match response.undamped {
            true => "nothing damps the motion: stable is what does not grow",
            false => "stable: both multipliers of the true motion lie inside the unit circle",
        }
    )));
    blocks
}

/// The method that finds the branches.
fn method(response: &ResponseDiagram) -> &'static str {
    if coupled::is_coupled(response) {
        return "shooting";
    }
    match (response.by_map, response.jumps) {
        (true, true) if !response.question.walls.is_empty() => {
            "the map of a period from impact to impact"
        }
        (true, true) if !response.question.events.is_empty() => {
            "the map of a period from event to event"
        }
        (true, true) => "the map of a period from jump to jump of the force",
        (true, false) => "shooting, across the corners of the force",
        (false, _) => "harmonic balance",
    }
}

/// The judge of the points of the branches.
fn judge(response: &ResponseDiagram) -> &'static str {
    if coupled::is_coupled(response) {
        return "a period by Taylor series";
    }
    match response.by_map && !response.jumps {
        true => "a period by Runge-Kutta",
        false => "shooting",
    }
}

/// The quantities that are computed and listed of motions without drive.
fn self_excited(response: &ResponseDiagram) -> [Block<'static>; 2] {
    let (name, [low, high]) = (response.question.parameter, response.question.range);
    let frequency = &response.frequency;
    [
        format!(
            "{name} from {} to {}; nothing drives the motion: {}, harmonics 0 to {}; theta = {}, and {frequency} is an \
             unknown of each motion.",
            decimal(low),
            decimal(high),
            method(response),
            response.harmonics,
            phase(response)
        ),
        "amplitude: of the first harmonic; peak: half of peak to peak; stable: the multiplier of the true motion lies inside the unit \
         circle; the other one, along the motion, is 1."
            .to_owned(),
    ]
    .map(Block::Sentence)
}

/// The frequency of the motion, as a factor of time.
#[cfg(feature = "json")]
pub(crate) fn motion_frequency(response: &ResponseDiagram) -> String {
    let frequency = &response.frequency;
    let text = match frequency.terms().len() > 1 {
        true => format!("({frequency})"),
        false => frequency.to_string(),
    };
    match response.question.periods {
        1 => text,
        periods => format!("{text}/{periods}"),
    }
}

/// theta as a function of time.
fn phase(response: &ResponseDiagram) -> String {
    let time = Expr::product([response.frequency.clone(), Expr::symbol("t")]);
    match (time.terms().len(), response.question.periods) {
        (_, 1) => time.to_string(),
        (1, periods) => format!("{time}/{periods}"),
        (_, periods) => format!("({time})/{periods}"),
    }
}

fn numbers(values: &Values) -> impl Iterator<Item = (Symbol, f64)> {
    values.numbers().into_iter()
}

/// The indices of the rows: the ends, equal steps between, and the points beside every change of
/// stability.
fn rows(points: &[SteadyMotion]) -> Vec<usize> {
    let count = points.len();
    let steps = ROWS.min(count).max(2) - 1;
    let mut rows: Vec<usize> = (0..=steps).map(|step| step * (count.max(1) - 1) / steps).collect();
    rows.dedup();
    rows
}

/// Whether a motion is stable, in a cell of a table.
fn yes_or_no(stable: Option<bool>) -> &'static str {
    match stable {
        Some(true) => "yes",
        Some(false) => "no",
        None => "-",
    }
}

/// The cells on stability, the largest multiplier and the error of a point.
fn stability_cells(point: &SteadyMotion) -> [String; 3] {
    let largest = point.multipliers.map(|multipliers| multipliers[0].norm());
    [
        yes_or_no(point.stable).to_owned(),
        largest.map_or("-".to_owned(), |largest| significant(largest, 4)),
        point.error.map_or("-".to_owned(), |error| significant(error, 2)),
    ]
}

/// The table of some points of a branch of one coordinate.
fn points<'a>(
    response: &ResponseDiagram,
    points: impl Iterator<Item = &'a SteadyMotion>,
) -> Block<'static> {
    let name = response.question.parameter.name();
    let row = |point: &SteadyMotion| {
        let place = match response.self_excited {
            true => vec![
                decimal(point.frequency),
                decimal(std::f64::consts::TAU / point.frequency),
                decimal(point.peak),
            ],
            false => vec![decimal(point.phase), decimal(point.peak)],
        };
        let first = [decimal(point.parameter), decimal(point.amplitude)].into_iter();
        first.chain(place).chain(stability_cells(point)).collect()
    };
    let columns: &[&'static str] = match response.self_excited {
        true => {
            &[name, "amplitude", "frequency", "period", "peak", "stable", "multiplier", "error"]
        }
        false => &[name, "amplitude", "phase", "peak", "stable", "multiplier", "error"],
    };
    Block::table(columns.iter().copied(), points.map(row))
}

fn branch(response: &ResponseDiagram, index: usize, branch: &Branch) -> Vec<Block<'static>> {
    let chosen = rows(&branch.points).into_iter().filter_map(|index| branch.points.get(index));
    let mut blocks = vec![
        Block::Heading(format!("branch {}: {}", index + 1, extent_in_words(response, branch))),
        match coupled::is_coupled(response) {
            true => coupled::points(response, chosen),
            false => points(response, chosen),
        },
    ];
    if branch.mirrored && coupled::is_coupled(response) {
        blocks.push(Block::Sentence(coupled::mirror_image(response)));
    } else if branch.mirrored {
        let image = match response.self_excited {
            true => "-x",
            false => "-x half a period of the drive later",
        };
        blocks.push(Block::Sentence(format!(
            "Its mirror image, {image}, is a branch as well, with the same amplitudes."
        )));
    }
    blocks.extend(sticking(response, branch));
    blocks.extend(impacts_and_events(response, branch));
    let ends = branch.ends.iter().zip([branch.points.first(), branch.points.last()]);
    let ends = ends.filter_map(|(end, point)| end_in_words(response, *end, point?));
    blocks.extend(ends.map(Block::Sentence));
    blocks
}

/// The reason why a branch ends at a point, in words; `None` if it needs no mention.
fn end_in_words(
    response: &ResponseDiagram,
    end: BranchEnd,
    point: &SteadyMotion,
) -> Option<String> {
    let place = format!("{} = {}", response.question.parameter, significant(point.parameter, 4));
    Some(match end {
        BranchEnd::Unbounded => format!("The amplitude grows without bound at {place}."),
        BranchEnd::Slow => format!(
            "No true motion was found beyond {place}, where its period is {}: it grows without bound beside a place of rest, or the \
             motion has more waves than are kept.",
            significant(std::f64::consts::TAU / point.frequency, 4)
        ),
        BranchEnd::Held => {
            format!("It comes to rest at {place}: beyond, friction bears what drives it.")
        }
        BranchEnd::ImpactAtStart => format!(
            "At {place} an {} falls on the beginning of a period, where the start of the motion jumps: what goes on beyond is listed as another branch if it was found.",
            jump_words(response)[0]
        ),
        BranchEnd::Grazing => {
            let [event, place_of_event] = jump_words(response);
            let followed = match point.impacts > MOST_IMPACTS * response.question.periods {
                true => format!(
                    "; from {MOST_IMPACTS} {event}s in a period of the drive on, motions beyond are not looked for"
                ),
                false => String::new(),
            };
            format!(
                "It grazes {place_of_event} at {place}: beyond, a period has an {event} less or more, and the map of a period has a root there{followed}."
            )
        }
        BranchEnd::Sensitive => format!(
            "It was followed no farther than {place}, where its period is {} and a disturbance grows about ten thousandfold in it: it may \
             pass slowly by a place of rest there, as near a homoclinic orbit.",
            significant(std::f64::consts::TAU / point.frequency, 4)
        ),
        BranchEnd::Lost if is_smooth(response) => format!(
            "It could not be followed beyond {place}: no step leads on there, however small."
        ),
        BranchEnd::Lost if response.jumps => format!(
            "It could not be followed beyond {place}: the motion begins to touch a jump of the force there, or the force has no value."
        ),
        BranchEnd::Lost if response.by_map => format!(
            "It could not be followed beyond {place}: the motion begins to touch a corner of the force there, or the force has no value."
        ),
        BranchEnd::Lost => format!(
            "It could not be followed beyond {place}: the force has a jump or no value there."
        ),
        BranchEnd::Harmonics => format!(
            "It was followed no farther than {place}: beyond, {} harmonics do not suffice, the last of them are a tenth of the motion or more.",
            response.harmonics
        ),
        BranchEnd::Points => {
            format!("It was followed no farther than {place}: it has too many points.")
        }
        BranchEnd::Interrupted => format!("It was followed no farther than {place}: interrupted."),
        BranchEnd::Range | BranchEnd::Closed | BranchEnd::Crossing | BranchEnd::Rest => {
            return None;
        }
    })
}

/// Whether the forces have values and all derivatives everywhere, and nothing sets a state to another value.
fn is_smooth(response: &ResponseDiagram) -> bool {
    let question = &response.question;
    let forces = match &question.equations {
        Equations::One(oscillator) => std::slice::from_ref(&oscillator.force),
        Equations::Coupled(equations) => &equations.rates.right,
    };
    question.walls.is_empty()
        && question.events.is_empty()
        && forces.iter().all(Expr::is_smooth_everywhere)
}

/// The words for a jump of states, and for the place where it happens.
fn jump_words(response: &ResponseDiagram) -> [&'static str; 2] {
    let question = &response.question;
    match (question.walls.is_empty(), question.events.is_empty()) {
        (false, true) => ["impact", "a wall"],
        (true, _) => ["event", "the condition of an event"],
        (false, false) => ["impact or event", "a wall or the condition of an event"],
    }
}

/// The numbers of impacts and of events in a period along a branch.
fn impacts_and_events(response: &ResponseDiagram, branch: &Branch) -> Vec<Block<'static>> {
    let question = &response.question;
    let impacts: (_, _, fn(&SteadyMotion) -> usize) =
        ("Impacts", question.walls.is_empty(), |point| point.impacts);
    let events: (_, _, fn(&SteadyMotion) -> usize) =
        ("Events", !response.has_events(), |point| point.events);
    let of_motion = [impacts, events].into_iter().filter(|(_, is_absent, _)| !is_absent);
    let of_motion = of_motion.map(|(what, _, count)| {
        let count = |point: &SteadyMotion| match count(point) {
            0 => "none".to_owned(),
            count => count.to_string(),
        };
        stretches(response, branch, &format!("{what} in a period:"), count)
    });
    let is_counted = branch.points.iter().any(|point| !point.counted.is_empty());
    let counters = response.counters.iter().enumerate().filter(|_| is_counted);
    let counted = counters.map(|(index, name)| {
        let value = |point: &SteadyMotion| match point.counted.get(index) {
            Some(value) => significant(*value, 6),
            None => "-".to_owned(),
        };
        // What is summed up along the motion changes with it from point to point.
        const MOST_NUMBERS: usize = 12;
        let stretches_of_one = branch.points.chunk_by(|one, other| value(one) == value(other));
        if stretches_of_one.count() <= MOST_NUMBERS {
            return stretches(response, branch, &format!("A period takes {name} from 0 to"), value);
        }
        let values = branch.points.iter().filter_map(|point| point.counted.get(index));
        let low = values.clone().copied().fold(f64::INFINITY, f64::min);
        let high = values.copied().fold(f64::NEG_INFINITY, f64::max);
        let [low, high] = [low, high].map(|value| significant(value, 4));
        Block::Sentence(format!("A period takes {name} from 0 to between {low} and {high}."))
    });
    of_motion.chain(counted).collect()
}

/// The numbers in a period of what a count counts, along a branch.
fn stretches(
    response: &ResponseDiagram,
    branch: &Branch,
    what: &str,
    value: impl Fn(&SteadyMotion) -> String,
) -> Block<'static> {
    /// Largest number of listed parts.
    const MOST: usize = 6;
    let name = response.question.parameter;
    let stretches: Vec<String> = branch
        .points
        .chunk_by(|one, other| value(one) == value(other))
        .map(|stretch| {
            let parameters = stretch.iter().map(|point| point.parameter);
            let low = parameters.clone().fold(f64::INFINITY, f64::min);
            let high = parameters.fold(f64::NEG_INFINITY, f64::max);
            let value = value(&stretch[0]);
            format!("{value} from {name} = {} to {}", significant(low, 4), significant(high, 4))
        })
        .collect();
    let more = if stretches.len() > MOST { ", and so on" } else { "" };
    Block::Sentence(format!("{what} {}{more}.", stretches[..stretches.len().min(MOST)].join(", ")))
}

/// Whether a part of an expression jumps.
fn is_jump(part: &Expr) -> bool {
    matches!(part.node(), Node::Function(Function::Sign | Function::Step, _))
}

/// The parts of a branch on which dry friction holds the motion for a time, or it rests on a wall.
fn sticking(response: &ResponseDiagram, branch: &Branch) -> Option<Block<'static>> {
    /// Largest number of listed parts.
    const MOST: usize = 4;
    let name = response.question.parameter;
    let sticks = |point: &SteadyMotion| point.stuck > 0.0;
    let stretches = branch.points.chunk_by(|one, other| sticks(one) == sticks(other));
    let stretches: Vec<String> = stretches
        .filter(|stretch| stretch.first().is_some_and(sticks))
        .map(|stretch| {
            let parameters = stretch.iter().map(|point| point.parameter);
            let low = parameters.clone().fold(f64::INFINITY, f64::min);
            let high = parameters.fold(f64::NEG_INFINITY, f64::max);
            format!("from {name} = {} to {}", significant(low, 4), significant(high, 4))
        })
        .collect();
    if stretches.is_empty() {
        return None;
    }
    let longest = branch.points.iter().map(|point| point.stuck).fold(0.0, f64::max);
    let more = match stretches.len() > MOST {
        true => ", and elsewhere",
        false => "",
    };
    // Of one coordinate nothing moves where all of a period is a stop.
    let place = match longest == 1.0 {
        true => {
            " Where that is all of it something stays where it came to rest: it may be held at other places as well, of which no branches are listed."
        }
        false => "",
    };
    let question = &response.question;
    let has_jump = |(left, right): &(Expr, Expr)| {
        [left, right].into_iter().any(|side| side.unique_nodes().any(is_jump))
    };
    if !question.walls.is_empty() && !question.equations.sides().iter().any(has_jump) {
        return Some(Block::Sentence(format!(
            "It rests on a wall on its way {}{more}: for {} % of a period at most, after impacts that accumulate, infinitely many in a finite time, \
             which are not counted below.",
            stretches[..stretches.len().min(MOST)].join(", "),
            significant(100.0 * longest, 3)
        )));
    }
    Some(Block::Sentence(format!(
        "It sticks on its way, held by friction, {}{more}: for {} % of a period at most.{place} There the points are those of the map of a \
         period, with the harmonics of the true motion.",
        stretches[..stretches.len().min(MOST)].join(", "),
        significant(100.0 * longest, 3)
    )))
}

/// The range of a branch, its number of points, and the number of stable ones, in words.
fn extent_in_words(response: &ResponseDiagram, branch: &Branch) -> String {
    let points = &branch.points;
    let name = response.question.parameter;
    let stable = points.iter().filter(|point| point.stable == Some(true)).count();
    let low = points.iter().map(|point| point.parameter).fold(f64::INFINITY, f64::min);
    let high = points.iter().map(|point| point.parameter).fold(f64::NEG_INFINITY, f64::max);
    let closed = if branch.ends[0] == BranchEnd::Closed { "closed, " } else { "" };
    format!(
        "{closed}{} points, {stable} of them stable, {name} from {} to {}",
        points.len(),
        decimal(low),
        decimal(high)
    )
}

/// The name of a kind of bifurcation.
pub fn bifurcation_in_words(kind: BifurcationKind) -> &'static str {
    match kind {
        BifurcationKind::Fold => "fold",
        BifurcationKind::BranchPoint => "branch point",
        BifurcationKind::PeriodDoubling => "period doubling",
        BifurcationKind::NeimarkSacker => "Neimark-Sacker",
        BifurcationKind::Hopf => "Hopf",
        BifurcationKind::Centre => "centre",
        BifurcationKind::Grazing => "grazing",
    }
}

fn changes(response: &ResponseDiagram) -> Option<Vec<Block<'static>>> {
    let all = &response.bifurcations;
    if all.is_empty() && response.ripple.is_none() {
        return None;
    }
    let name = response.question.parameter.name();
    let has_frequency = response.self_excited && !are_modes(response);
    // A motion at even multiples of the frequency alone has an amplitude of rounding where others branch off.
    const ROUNDING: f64 = 1e-7;
    let row = |bifurcation: &crate::response::Bifurcation| {
        let mut row = vec![
            coupled::kind_in_words(bifurcation.kind, bifurcation.criticality),
            decimal(bifurcation.parameter),
            match bifurcation.amplitude < ROUNDING * bifurcation.peak {
                true => "0".to_owned(),
                false => decimal(bifurcation.amplitude),
            },
            decimal(bifurcation.peak),
            (bifurcation.branch + 1).to_string(),
        ];
        if has_frequency {
            row.insert(3, decimal(bifurcation.frequency));
        }
        row
    };
    let mut columns = vec!["", name, "amplitude", "peak", "branch"];
    if has_frequency {
        columns.insert(3, "frequency");
    }
    let mut blocks = vec![Block::Heading("where branches change".to_owned())];
    if all.is_empty() {
        blocks.extend(ripple(response));
        return Some(blocks);
    }
    blocks.push(Block::table(columns, all.iter().take(MOST_BIFURCATIONS).map(row)));
    if all.len() > MOST_BIFURCATIONS {
        blocks.push(Block::Note(format!("and {} more", all.len() - MOST_BIFURCATIONS)));
    }
    let meaning = |kind: BifurcationKind| match kind {
        BifurcationKind::Fold if coupled::are_modes(response) => {
            "At a fold the family turns back in its frequency."
        }
        BifurcationKind::Fold if response.self_excited => "At a fold two cycles meet and vanish.",
        BifurcationKind::Fold => "At a fold the motion jumps to another branch.",
        BifurcationKind::BranchPoint => "At a branch point another branch crosses.",
        BifurcationKind::PeriodDoubling => {
            "At a period doubling motions of twice the period come off."
        }
        BifurcationKind::NeimarkSacker => "At a Neimark-Sacker point a second frequency comes in.",
        BifurcationKind::Hopf => "At a Hopf point the motion is born from rest.",
        BifurcationKind::Centre => "At a centre motions of every amplitude repeat themselves.",
        BifurcationKind::Grazing if response.question.walls.is_empty() => {
            "At a grazing the motion touches the condition of an event: beyond it there is an event more, or one less, in a period."
        }
        BifurcationKind::Grazing => {
            "At a grazing the motion touches a wall: beyond it there is an impact more, or one less, in a period."
        }
    };
    let mut kinds: Vec<BifurcationKind> = all.iter().map(|bifurcation| bifurcation.kind).collect();
    kinds.sort();
    kinds.dedup();
    let words: Vec<&str> = kinds.into_iter().map(meaning).collect();
    blocks.push(Block::Sentence(words.join(" ")));
    blocks.extend(ripple(response));
    Some(blocks)
}

/// A note on folds that were left out.
fn ripple(response: &ResponseDiagram) -> Option<Block<'static>> {
    let ripple = response.ripple?;
    let name = response.question.parameter.name();
    let [low, high] = ripple.range.map(decimal);
    Some(Block::Sentence(format!(
        "{} folds of the balance from {name} = {low} to {high} are left out: no multiplier of the true motion passes 1 there. They are ripple \
         of {} harmonics{}.",
        ripple.folds,
        response.harmonics,
        match response.harmonics < MOST_HARMONICS {
            true => format!(", and fewer where more are kept, {MOST_HARMONICS} at most"),
            false => String::new(),
        }
    )))
}

fn backbone(response: &ResponseDiagram) -> Option<Vec<Block<'static>>> {
    const FEW: usize = 6;
    if response.backbone.is_empty() {
        return None;
    }
    let name = response.question.parameter.name();
    let mut blocks = vec![Block::Heading("backbone: the free motion without damping".to_owned())];
    for curve in &response.backbone {
        let count = curve.len();
        let chosen = (0..FEW).map(|index| &curve[index * (count - 1) / (FEW - 1)]);
        blocks.push(Block::table(
            [name, "amplitude"],
            chosen.map(|point| vec![decimal(point.parameter), decimal(point.amplitude)]),
        ));
    }
    Some(blocks)
}

/// The slow equations, their steady motions, and the differences of these from the branches.
/// The slow equations of a single coordinate, and their relation of steady motions.
fn slow_equations_of_one(solution: &Solution) -> Vec<Block<'static>> {
    let mut blocks = Vec::new();
    let line =
        |left: Expr, right: Expr| Block::Line(Cow::Owned(DerivationLine::equation(left, right)));
    if let Some(modulation) = &solution.modulation {
        let rate = |name: Symbol| Expr::from(name.derivative());
        blocks.push(line(rate(modulation.amplitude), modulation.amplitude_rate.clone()));
        blocks.push(line(rate(modulation.phase), modulation.phase_rate.clone()));
    }
    let definitions = solution.definitions.iter();
    blocks.extend(
        definitions
            .map(|definition| line(Expr::from(definition.symbol), definition.meaning.clone())),
    );
    if let Some(relation) =
        solution.response.as_ref().and_then(|response| response.relation.as_ref())
    {
        blocks.push(line(Expr::zero(), Expr::from(relation)));
    }
    blocks
}

fn by_slow_equations(response: &ResponseDiagram, slow: &SlowResponse) -> Vec<Block<'static>> {
    let name = response.question.parameter.name();
    let mut blocks = vec![Block::Heading(format!("by slow equations: {}", slow.equations.title()))];
    match &slow.equations {
        SlowEquations::One(solution) => blocks.extend(slow_equations_of_one(solution)),
        SlowEquations::Coupled(slow) => {
            blocks.extend(super::slow_equations::rates(slow).unwrap_or_default());
        }
    }
    let count = slow.states.len();
    let steps = ROWS.min(count).max(2) - 1;
    let row = |step: usize| {
        let state = slow.states.get(step * (count.max(1) - 1) / steps)?;
        let stable = if state.stable { "yes" } else { "no" };
        let second = state.peak.unwrap_or(state.amplitude);
        let third = if state.peak.is_some() { state.amplitude } else { state.phase };
        let numbers = [state.parameter, second, third].map(decimal);
        Some(numbers.into_iter().chain([stable.to_owned()]).collect())
    };
    let coupled = matches!(slow.equations, SlowEquations::Coupled(_));
    let size = if coupled { "peak" } else { "amplitude" };
    let third = if coupled { "first harmonic" } else { "phase" };
    blocks.push(Block::table([name, size, third, "stable"], (0..=steps).filter_map(row)));
    let mut facts = vec![(
        "largest error",
        match (slow.error, slow.worst) {
            (Some(error), Some(worst)) => format!(
                "{} of the {size}, at {name} = {}, of {} stable points of the branches",
                significant(error, 2),
                significant(worst, 4),
                slow.points
            ),
            _ => {
                "unknown: no stable motion of the branches and of the slow equations stand beside each other".to_owned()
            }
        },
    )];
    if slow.missing > 0 {
        facts.push((
            "missing",
            format!(
                "{} stable points near which the slow equations have no stable motion",
                slow.missing
            ),
        ));
    }
    if slow.beside > 0 {
        facts.push((
            "not compared",
            format!(
                "{} stable points beside a branch point, where the amplitude grows as a root of the distance",
                slow.beside
            ),
        ));
    }
    if let Some(spurious) = slow.spurious {
        let [low, high] = spurious.amplitudes.map(decimal);
        facts.push((
            "left out",
            format!(
                "{} steady motions of the truncated slow equations, amplitudes from {low} to {high}: the last order is more than half \
                 of the one before it there, so that the series hardly converges",
                spurious.count
            ),
        ));
    }
    facts.push((
        "verdict",
        format!(
            "{} (error <= {}, one point in twenty missing at most)",
            slow.verdict.name(),
            significant(response.question.tolerance, 3)
        ),
    ));
    blocks.push(Block::Facts(facts));
    blocks
}

/// The growth of disturbances of the motions that are not judged, where that is why.
fn growing(response: &ResponseDiagram) -> Option<Block<'static>> {
    /// A growth in a period at which a simulation leaves the motion at once.
    const LARGE: f64 = 1e4;
    let points = response.branches.iter().flat_map(|branch| &branch.points);
    let unjudged = points.filter(|point| point.error.is_none());
    let growths = unjudged.filter_map(|point| Some(point.multipliers?[0].norm()));
    let growths: Vec<f64> = growths.filter(|growth| *growth >= LARGE).collect();
    if growths.is_empty() {
        return None;
    }
    let [low, high] = [f64::min as fn(f64, f64) -> f64, f64::max]
        .map(|choose| growths.iter().copied().reduce(choose).unwrap_or(f64::NAN));
    Some(Block::Sentence(format!(
        "Disturbances of {} of the motions that are not judged grow by a factor of {} to {} in a period, as beside a hilltop on which the \
         motion stays for long: they are unstable, nothing stays near them, and {} harmonics may not say where they are. A shorter \
         range, or fewer periods of the drive, has fewer of them.",
        growths.len(),
        significant(low, 2),
        significant(high, 2),
        response.harmonics
    )))
}

/// The stretches that are left out, or in which the search had too few starts.
fn sparse(response: &ResponseDiagram) -> Vec<Block<'static>> {
    let name = response.question.parameter.name();
    let [low, high] = response.question.range;
    let of = |is_left_out: bool| -> Option<String> {
        let stretches = response
            .sparse
            .iter()
            .filter(|stretch| (stretch[1] <= low || stretch[0] >= high) == is_left_out);
        let stretch = |[low, high]: &[f64; 2]| {
            format!("from {name} = {} to {}", significant(*low, 4), significant(*high, 4))
        };
        let stretches: Vec<String> = stretches.map(stretch).collect();
        (!stretches.is_empty()).then(|| stretches.join(" and "))
    };
    let left_out = of(true).map(|stretches| {
        format!(
            "The response {stretches} is left out: from one start of the search to the next the motion gains more than one swing in a \
             period of the drive there, so that the branches of whole resonances would be missing. Shorter ranges have closer starts."
        )
    });
    let thin = of(false).map(|stretches| {
        format!(
            "This is not the whole picture {stretches}: from one start of the search to the next the motion gains more than one swing in a \
             period of the drive there, and the branches of a resonance between two starts may be missing. Shorter ranges have closer \
             starts."
        )
    });
    left_out.into_iter().chain(thin).map(Block::Sentence).collect()
}

fn judgement(response: &ResponseDiagram) -> Vec<Block<'static>> {
    let name = response.question.parameter.name();
    let has_frequency = response.self_excited && !are_modes(response);
    let points: usize = response.branches.iter().map(|branch| branch.points.len()).sum();
    let mut facts = vec![(
        "largest error",
        match response.error {
            Some(error) => format!(
                "{} of the true {}, of {} points against {} and {} against simulation",
                significant(error, 2),
                if has_frequency { "peak or frequency" } else { "peak" },
                points - response.unjudged,
                judge(response),
                response.simulated.len()
            ),
            None if !response.complete => {
                "unknown: the work was stopped before a point was judged".to_owned()
            }
            None => "unknown: no true motion was found".to_owned(),
        },
    )];
    if response.unjudged > 0 {
        let (points, judge) = (response.unjudged, judge(response));
        let unjudged = match response.complete {
            true => format!("{points} points: {judge} found no true motion near"),
            false => format!(
                "{points} points: the work was stopped before {judge} found a true motion near"
            ),
        };
        facts.push(("not judged", unjudged));
    }
    facts.push((
        "verdict",
        format!(
            "{} (error <= {})",
            response.verdict.name(),
            significant(response.question.tolerance, 3)
        ),
    ));
    let mut blocks =
        vec![Block::Heading("judged against the true motion".to_owned()), Block::Facts(facts)];
    blocks.extend(growing(response));
    if response.exhausted {
        blocks.push(Block::Sentence(
            "The search was ended because each point takes long: branches may be missing or end early, and where they change was not \
             looked for. A shorter range, or a weaker drive, takes less."
                .to_owned(),
        ));
    } else if response.is_full() {
        blocks.push(Block::Sentence(format!(
            "There are {} branches, as many as are followed: others may be missing. A shorter range has fewer.",
            response.branches.len()
        )));
    }
    blocks.extend(sparse(response));
    let kind = |place: &Elsewhere| {
        (place.periods, place.drive_periods, place.aperiodic.as_ref().map(std::mem::discriminant))
    };
    let mut sorted: Vec<&Elsewhere> = response.elsewhere.iter().collect();
    sorted.sort_by_key(|place| (place.periods, place.drive_periods));
    let mut kinds: Vec<Vec<&Elsewhere>> = Vec::new();
    for place in sorted {
        match kinds.iter_mut().find(|places| kind(places[0]) == kind(place)) {
            Some(places) => places.push(place),
            None => kinds.push(vec![place]),
        }
    }
    for places in kinds {
        let mut values: Vec<String> =
            places.iter().map(|place| significant(place.parameter, 4)).collect();
        values.dedup();
        let largest = places.iter().max_by(|one, other| one.peak.total_cmp(&other.peak));
        let Some(largest) = largest else { continue };
        let sentence = settles_elsewhere(response, largest);
        let own = match largest.aperiodic {
            Some(AperiodicMotion::QuasiPeriodic(motion)) => {
                format!(", the second frequency {},", significant(motion.second_frequency, 6))
            }
            Some(AperiodicMotion::Chaotic(motion)) => format!(
                ", the Lyapunov exponent {} +- {},",
                significant(motion.lyapunov_exponent, 3),
                significant(motion.lyapunov_error, 1)
            ),
            Some(AperiodicMotion::Rotating(motion)) => format!(
                ", moves on by {}*2*pi in {} of the drive,",
                motion.turns,
                periods_in_words(motion.in_periods * response.question.periods)
            ),
            Some(AperiodicMotion::Unsettled(..)) | None => String::new(),
        };
        blocks.push(Block::Sentence(format!(
            "At {name} = {} a simulation {sentence} The largest has the peak {} at {name} = {}{own} and begins at {}.",
            values.join(", "),
            significant(largest.peak, 4),
            significant(largest.parameter, 4),
            coupled::states_in_words(response, largest)
        )));
    }
    blocks
}

/// A number of periods, in words.
fn periods_in_words(count: usize) -> String {
    match count {
        1 => "one period".to_owned(),
        count => format!("{count} periods"),
    }
}

/// The end of a sentence that says on what a simulation settles that is on no branch.
fn settles_elsewhere(response: &ResponseDiagram, place: &Elsewhere) -> String {
    let periods = response.question.periods;
    match (place.periods, place.aperiodic) {
        (Some(1), _) => format!(
            "settles on a motion that lies on none of these branches: {} has not come to it. {} may find its branch.",
            method(response),
            match response.by_map || response.harmonics >= MOST_HARMONICS {
                true => "Another range".to_owned(),
                false => format!("More harmonics, {MOST_HARMONICS} at most, or another range"),
            }
        ),
        (Some(count), _) => format!(
            "settles on a motion of {} periods of the drive, which is not among these branches.",
            place.drive_periods.unwrap_or(count * periods)
        ),
        (None, Some(AperiodicMotion::QuasiPeriodic(..))) => {
            "settles on a quasi-periodic motion, with a second frequency beside that of the drive."
                .to_owned()
        }
        (None, Some(AperiodicMotion::Chaotic(..))) => {
            "goes on in chaos: motions nearby part from it.".to_owned()
        }
        (None, Some(AperiodicMotion::Rotating(..))) => {
            "settles on a rotation, which is periodic but for whole turns.".to_owned()
        }
        (None, Some(AperiodicMotion::Unsettled(motion))) => format!(
            "has not settled in time: {} more periods of the drive show no other period, no second frequency and no chaos.",
            motion.followed_periods * periods
        ),
        (None, None) => "does not come to repeat itself.".to_owned(),
    }
}

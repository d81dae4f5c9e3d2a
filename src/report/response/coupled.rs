//! What a report says of coupled equations beside that of one coordinate: the motions of all
//! coordinates, equilibria, and bifurcations in two parameters.

use super::bifurcation_in_words;
use crate::decimal::{decimal, significant};
use crate::report::{Block, Heading};
use crate::response::bifurcation::BifurcationKind;
use crate::response::{
    BifurcationCurve, Criticality, Elsewhere, Equations, EquilibriumBranch, ResponseDiagram,
    StableMotions, SteadyMotion,
};
use crate::symbol::Symbol;

/// Largest number of coordinates with a column of their own.
const MOST_COLUMNS: usize = 4;

/// Number of rows of the table of a branch of equilibria.
const EQUILIBRIUM_ROWS: usize = 9;

/// Number of rows of the table of a curve of bifurcations, and of that of numbers of stable motions.
const CURVE_ROWS: usize = 7;

/// Number of columns of the table of numbers of stable motions.
const COUNT_COLUMNS: usize = 9;

/// An amplitude below this part of the largest peak is that of rounding, and printed as zero: of a
/// coordinate that moves at even multiples of the frequency alone, as one that a square drives.
const ROUNDING: f64 = 1e-9;

/// Whether the equations are coupled, or of first order.
pub(super) fn is_coupled(response: &ResponseDiagram) -> bool {
    response.question.equations.oscillator().is_none()
}

/// Whether nothing drives or damps the motions of coupled equations, so that they are nonlinear
/// normal modes.
pub(crate) fn are_modes(response: &ResponseDiagram) -> bool {
    is_coupled(response) && response.self_excited && response.undamped
}

/// Whether the energies of the motions are known.
pub(crate) fn has_energy(response: &ResponseDiagram) -> bool {
    let mut points = response.branches.iter().flat_map(|branch| &branch.points);
    points.next().is_some_and(|point| point.energy.is_some())
}

/// The quantity that is listed, as a text.
pub(crate) fn listed_quantity(response: &ResponseDiagram) -> String {
    let question = &response.question;
    match &question.of {
        Some(quantity) => quantity.to_string(),
        None => response.coordinates().first().map(Symbol::to_string).unwrap_or_default(),
    }
}

/// The coordinates that have a column of their own; none if they are too many.
fn columns_of_their_own(response: &ResponseDiagram) -> Vec<Symbol> {
    let coordinates = response.coordinates();
    if coordinates.len() <= MOST_COLUMNS { coordinates } else { vec![] }
}

/// The sentences on parameter, method and quantities.
pub(super) fn question(response: &ResponseDiagram) -> Vec<Block<'static>> {
    let asked = &response.question;
    let (name, [low, high]) = (asked.parameter, asked.range.map(decimal));
    let motion = match (are_modes(response), response.self_excited) {
        (true, _) => format!(
            "nothing drives or damps the motion: nonlinear normal modes, each with a motion for every energy; {name} is their frequency; \
             shooting, harmonics 0 to {}; theta = {}",
            response.harmonics,
            super::phase(response)
        ),
        (false, true) => format!(
            "nothing drives the motion: shooting, harmonics 0 to {}; theta = {}, and {} is an unknown of each motion",
            response.harmonics,
            super::phase(response),
            response.frequency
        ),
        (false, false) => format!(
            "shooting, harmonics 0 to {}; theta = {}, and a motion takes {} of the drive",
            response.harmonics,
            super::phase(response),
            match asked.periods {
                1 => "one period".to_owned(),
                periods => format!("{periods} periods"),
            }
        ),
    };
    let kept_apart = counters(response).into_iter().chain(modes(response)).map(Block::Sentence);
    let listed = listed_quantity(response);
    let amplitudes = match columns_of_their_own(response).is_empty() {
        true => format!("amplitude: of the first harmonic of {listed}"),
        false => "amplitude: of the first harmonic of a coordinate".to_owned(),
    };
    let stable = match (response.undamped, response.self_excited) {
        (true, _) => "nothing damps the motion: stable is what does not grow",
        (false, true) => {
            "stable: all multipliers of the true motion but the one along it, which is 1, lie inside the unit circle; multiplier: the largest \
             of them"
        }
        (false, false) => {
            "stable: all multipliers of the true motion lie inside the unit circle; multiplier: the largest"
        }
    };
    [
        format!("{name} from {low} to {high}; {motion}."),
        format!(
            "{amplitudes}; peak: half of peak to peak of {listed}; {}{stable}.",
            if has_energy(response) { "energy: over that of rest; " } else { "" }
        ),
    ]
    .map(Block::Sentence)
    .into_iter()
    .chain(kept_apart)
    .collect()
}

/// The sentence on the states that only count; `None` without them.
fn counters(response: &ResponseDiagram) -> Option<String> {
    let names: Vec<String> = response.counters.iter().map(Symbol::to_string).collect();
    let (verb, belong) = match names.len() {
        0 => return None,
        1 => ("counts, and enters", "it does not belong"),
        _ => ("count, and enter", "they do not belong"),
    };
    Some(format!(
        "{} only {verb} neither a force nor a condition: {belong} to the motion, and neither do events that set nothing else.",
        names.join(", ")
    ))
}

/// The sentence on the values of modes; `None` without them.
fn modes(response: &ResponseDiagram) -> Option<String> {
    let of_mode = |(name, values): &(Symbol, Vec<f64>)| {
        let values: Vec<String> = values.iter().map(|value| decimal(*value)).collect();
        format!("{name} is {}", values.join(" or "))
    };
    let all: Vec<String> = response.modes.iter().map(of_mode).collect();
    (!all.is_empty()).then(|| {
        format!(
            "{}, and changes at events alone: a motion repeats itself where it is again what it was.",
            all.join(", ")
        )
    })
}

/// A text as the heading of a column.
fn heading(text: &str) -> Heading {
    // The names of symbols live as long as the program, and those of coordinates are few.
    let kept = |text: &str| Symbol::new(text).name();
    Heading { text: kept(text), latex: kept(&text.replace('_', "\\_")) }
}

/// The table of some points of a branch.
pub(super) fn points<'a>(
    response: &ResponseDiagram,
    points: impl Iterator<Item = &'a SteadyMotion>,
) -> Block<'static> {
    let own = columns_of_their_own(response);
    let has_frequency = response.self_excited && !are_modes(response);
    let mut columns = vec![heading(response.question.parameter.name())];
    match own.is_empty() {
        true => columns.push("amplitude".into()),
        false => columns.extend(own.iter().map(|name| heading(&format!("amplitude {name}")))),
    }
    columns.extend(has_frequency.then(|| Heading::from("frequency")));
    let has_energy = has_energy(response);
    columns.extend(has_energy.then(|| Heading::from("energy")));
    columns.extend(["peak", "stable", "multiplier", "error"].map(Heading::from));
    let rows = points.map(|point| {
        let mut row = vec![decimal(point.parameter)];
        match own.is_empty() {
            true => row.push(decimal(point.amplitude)),
            false => {
                let peaks = point.coordinates.iter().map(|motion| motion.peak);
                let least = ROUNDING * peaks.fold(0.0, f64::max);
                let amplitudes = point.coordinates.iter().map(|motion| motion.amplitude);
                row.extend(amplitudes.map(|amplitude| match amplitude < least {
                    true => decimal(0.0),
                    false => decimal(amplitude),
                }));
            }
        }
        row.extend(has_frequency.then(|| decimal(point.frequency)));
        row.extend(point.energy.filter(|_| has_energy).map(decimal));
        row.push(decimal(point.peak));
        row.extend(super::stability_cells(point));
        row
    });
    Block::table(columns, rows)
}

/// The words for the side on which motions come off.
fn criticality_in_words(criticality: Criticality) -> &'static str {
    match criticality {
        Criticality::Subcritical => "subcritical",
        Criticality::Supercritical => "supercritical",
        Criticality::StronglyResonant => "strongly resonant",
    }
}

/// The name of a kind of bifurcation, and whether what comes off is stable, where that is known.
pub(super) fn kind_in_words(kind: BifurcationKind, criticality: Option<Criticality>) -> String {
    let kind = bifurcation_in_words(kind);
    match criticality {
        Some(criticality) => format!("{kind}, {}", criticality_in_words(criticality)),
        None => kind.to_owned(),
    }
}

/// The sentence on the mirror image of a branch.
pub(super) fn mirror_image(response: &ResponseDiagram) -> String {
    let coordinates = response.coordinates();
    let image: Vec<String> = coordinates.iter().map(|name| format!("-{name}")).collect();
    let later = match response.self_excited {
        true => "",
        false => " half a period of the drive later",
    };
    format!(
        "Its mirror image, {}{later}, is a branch as well, with the same amplitudes.",
        image.join(", ")
    )
}

/// The states at the beginning of a motion elsewhere, in words.
pub(super) fn states_in_words(response: &ResponseDiagram, place: &Elsewhere) -> String {
    let values = if place.state.is_empty() { &place.start[..] } else { &place.state };
    let states = state_names(response).into_iter().zip(values);
    let states: Vec<String> =
        states.map(|(name, value)| format!("{name} = {}", significant(*value, 6))).collect();
    states.join(", ")
}

/// The states of the equations: the coordinates, then the velocities of those of second order.
fn state_names(response: &ResponseDiagram) -> Vec<Symbol> {
    match &response.question.equations {
        Equations::Coupled(equations) => {
            let is_of_motion = |name: &&Symbol| !response.counters.contains(name);
            equations.rates.states.iter().filter(is_of_motion).copied().collect()
        }
        Equations::One(oscillator) => {
            vec![oscillator.coordinate, oscillator.velocity()]
        }
    }
}

/// Some of a number of indices, at equal steps, with both ends.
fn some_of(count: usize, most: usize) -> Vec<usize> {
    let steps = most.min(count).max(2) - 1;
    let mut chosen: Vec<usize> =
        (0..=steps).map(|step| step * (count.max(1) - 1) / steps).collect();
    chosen.dedup();
    chosen
}

/// The equilibria of a system that nothing drives, branch by branch, with their changes.
pub(super) fn equilibria(response: &ResponseDiagram) -> Option<Vec<Block<'static>>> {
    if response.equilibria.is_empty() {
        return None;
    }
    let mut blocks = vec![
        Block::Heading("equilibria".to_owned()),
        Block::Sentence(format!(
            "value: of {}; stable: small disturbances die out; growth: the largest real part of an eigenvalue of the linear equations.",
            listed_quantity(response)
        )),
    ];
    for (index, branch) in response.equilibria.iter().enumerate() {
        blocks.extend(equilibrium_branch(response, index, branch));
    }
    Some(blocks)
}

fn equilibrium_branch(
    response: &ResponseDiagram,
    index: usize,
    branch: &EquilibriumBranch,
) -> Vec<Block<'static>> {
    let name = response.question.parameter.name();
    let points = &branch.points;
    let stable = points.iter().filter(|point| point.stable == Some(true)).count();
    let mut blocks = vec![Block::Sentence(format!(
        "Branch {} of equilibria: {} points, {stable} of them stable.",
        index + 1,
        points.len()
    ))];
    let rows = some_of(points.len(), EQUILIBRIUM_ROWS).into_iter().filter_map(|index| {
        let point = points.get(index)?;
        Some(vec![
            decimal(point.parameter),
            decimal(point.value),
            super::yes_or_no(point.stable).to_owned(),
            point.growth.map_or("-".to_owned(), |growth| significant(growth, 4)),
        ])
    });
    blocks.push(Block::table(
        [heading(name), "value".into(), "stable".into(), "growth".into()],
        rows,
    ));
    if !branch.changes.is_empty() {
        let rows = branch.changes.iter().map(|change| {
            vec![
                kind_in_words(change.kind, change.criticality),
                decimal(change.parameter),
                decimal(change.value),
            ]
        });
        blocks.push(Block::table(["".into(), heading(name), "value".into()], rows));
    }
    blocks
}

/// The curves of bifurcations in two parameters, and the numbers of stable motions.
pub(super) fn two_parameters(response: &ResponseDiagram) -> Option<Vec<Block<'static>>> {
    let (along, [low, high]) = response.question.along?;
    let parameter = response.question.parameter;
    let mut blocks =
        vec![Block::Heading(format!("bifurcations in two parameters, {parameter} and {along}"))];
    blocks.push(Block::Sentence(match response.curves.is_empty() {
        true => format!(
            "No bifurcation was followed in {along} from {} to {}.",
            decimal(low),
            decimal(high)
        ),
        false => format!(
            "Each curve begins at a bifurcation of the branches and is followed in {along} from {} to {}; peak: that of the motion there.",
            decimal(low),
            decimal(high)
        ),
    }));
    for (index, curve) in response.curves.iter().enumerate() {
        blocks.extend(bifurcation_curve(index, curve, [parameter, along]));
    }
    blocks.extend(response.stable_motions.iter().flat_map(|counts| {
        [
            Block::Sentence(format!("Number of stable motions; {along} down, {parameter} across:")),
            stable_motions(counts, along),
        ]
    }));
    Some(blocks)
}

fn bifurcation_curve(
    index: usize,
    curve: &BifurcationCurve,
    [parameter, along]: [Symbol; 2],
) -> [Block<'static>; 2] {
    let rows = some_of(curve.points.len(), CURVE_ROWS).into_iter().filter_map(|index| {
        let point = curve.points.get(index)?;
        Some([point.parameter, point.along, point.peak].map(decimal).to_vec())
    });
    [
        Block::Sentence(format!(
            "Curve {}: {}, {} points.",
            index + 1,
            bifurcation_in_words(curve.kind),
            curve.points.len()
        )),
        Block::table([heading(parameter.name()), heading(along.name()), "peak".into()], rows),
    ]
}

fn stable_motions(counts: &StableMotions, along: Symbol) -> Block<'static> {
    let across = some_of(counts.parameters.len(), COUNT_COLUMNS);
    let value = |column: &usize| counts.parameters.get(*column).copied().map(decimal);
    let head = across.iter().filter_map(value).map(|value| heading(&value));
    let rows = some_of(counts.along.len(), CURVE_ROWS).into_iter().filter_map(|row| {
        let cells = counts.counts.get(row)?;
        let cells = across
            .iter()
            .map(|column| cells.get(*column).map_or("-".to_owned(), ToString::to_string));
        Some(std::iter::once(decimal(*counts.along.get(row)?)).chain(cells).collect())
    });
    Block::table(std::iter::once(heading(along.name())).chain(head), rows)
}

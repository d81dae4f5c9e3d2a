//! Periodic impact orbits: laws in letters, orbits in numbers, changes along parameters.

use std::borrow::Cow;

use num_complex::Complex64;

use super::driven::values_in_words;
use super::{Block, Document, size_in_percent};
use crate::decimal::decimal;
use crate::derivation::DerivationLine;
use crate::expr::Expr;
use crate::orbits::{
    FoundOrbits, ImpactEquation, ImpactOrbit, JudgedImpactOrbit, OrbitBranch, OrbitChart,
    OrbitFamily, OrbitKind, OrbitLaws, OrbitStability, OrbitSweep,
};

/// Impact orbits to be reported.
#[derive(Clone, Copy, Debug)]
pub struct OrbitsReport<'a> {
    /// The equation and its walls.
    pub question: &'a ImpactEquation,
    /// The laws in letters.
    pub laws: &'a [OrbitLaws],
    /// The orbits at given values.
    pub found: Option<&'a FoundOrbits>,
    /// The orbits along a parameter.
    pub sweep: Option<&'a OrbitSweep>,
    /// The orbits over two parameters.
    pub chart: Option<&'a OrbitChart>,
}

/// The document of impact orbits.
///
/// ```
/// use lindstedt::orbits::{ImpactEquation, laws};
/// use lindstedt::report::{OrbitsReport, orbits};
/// use lindstedt::{Oscillator, wall::Wall};
///
/// let ball = Oscillator::parse("x'' + g = 0")?;
/// let table = Wall::parse("x > Z*sin(w*t)", &"e".parse()?)?;
/// let question = ImpactEquation::new(&ball, &table)?;
/// let laws = laws(&question)?;
/// let report =
///     OrbitsReport { question: &question, laws: &laws, found: None, sweep: None, chart: None };
/// let text = lindstedt::export::text::document(&orbits(&report), 100);
/// assert!(text.contains("v = g*T/(1 + e)"), "{text}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn orbits<'a>(report: &OrbitsReport<'a>) -> Document<'a> {
    let mut sections = vec![question(report.question)];
    let is_computed = report.sweep.is_some() || report.chart.is_some();
    for laws in report.laws.iter().filter(|_| !is_computed) {
        sections.push(heading_of_laws(report, laws));
        sections.push(
            laws.relations.iter().map(|own| line(own.words, &own.left, &own.right)).collect(),
        );
        let curves = laws.curves.iter().map(|own| line(own.words, &own.left, &own.right));
        let heading = Block::Heading("Where orbits change".to_owned());
        sections.push(std::iter::once(heading).chain(curves).collect());
    }
    sections.extend(report.found.map(|found| numbers(report.question, found)));
    sections.extend(report.sweep.map(along));
    sections.extend(report.chart.map(over_two));
    sections.push(validity(report, is_computed));
    Document { sections }
}

/// The equation and its walls.
fn question<'a>(question: &ImpactEquation) -> Vec<Block<'a>> {
    let equation = question.oscillator.equation();
    let mut blocks = vec![line("", &equation.left, &Expr::zero())];
    let walls = question.walls.iter().map(|own| {
        let wall = &own.wall;
        ("wall", format!("{} > 0 off it, restitution {}", wall.gap, wall.restitution))
    });
    blocks.push(Block::Facts(walls.collect()));
    blocks
}

/// The title of laws, the equation of the gap and the definitions.
fn heading_of_laws<'a>(report: &OrbitsReport<'a>, laws: &'a OrbitLaws) -> Vec<Block<'a>> {
    let which = match (laws.kind, report.question.walls.len()) {
        (OrbitKind::Symmetric, _) => "Symmetric orbits, one impact on each wall".to_owned(),
        (_, 1) => "Orbits with one impact".to_owned(),
        _ => format!("Orbits with one impact, on the wall {} = 0", laws.gap.meaning),
    };
    let [left, right] = &laws.equation;
    let mut blocks = vec![
        Block::Heading(which),
        line("gap", &Expr::from(laws.gap.symbol), &laws.gap.meaning),
        line("between impacts", left, right),
    ];
    blocks.extend(laws.definitions.iter().map(Block::Definition));
    blocks
}

fn line<'a>(words: &str, left: &Expr, right: &Expr) -> Block<'a> {
    let line = DerivationLine::equation(left.clone(), right.clone());
    Block::Line(Cow::Owned(line.because(words)))
}

/// The orbits at values.
fn numbers<'a>(question: &ImpactEquation, found: &FoundOrbits) -> Vec<Block<'a>> {
    let [least, greatest] = found.periods;
    let periods = match least == greatest {
        true => format!("n = {least}"),
        false => format!("n = {least} to {greatest}"),
    };
    let count = match found.impacts {
        1 => String::new(),
        count => format!(" with {count} impacts"),
    };
    let mut blocks =
        vec![Block::Heading(format!("Orbits{count}, {periods}{}", values_in_words(&found.at)))];
    if found.orbits.is_empty() {
        blocks.push(Block::Note(match found.impacts {
            1 => "no orbit: nowhere is the speed real and positive".to_owned(),
            _ => "no orbit was found; the search starts from many phases and speeds, and proves nothing about others".to_owned(),
        }));
    } else {
        blocks.push(orbit_table(question, found));
        blocks.push(multiplier_table(found));
    }
    for own in &found.orbits {
        blocks.extend(obstacle_in_words(question, &own.orbit).map(Block::Sentence));
    }
    if !found.degenerate.is_empty() {
        let periods: Vec<String> = found.degenerate.iter().map(ToString::to_string).collect();
        blocks.push(Block::Note(format!(
            "no orbit for n = {}: there the free motion returns to itself and cannot make up for the impact",
            periods.join(", ")
        )));
    }
    let within = size_in_percent(found.tolerance);
    blocks.push(Block::Facts(vec![(
        "verdict",
        match found.verdict {
            Some(verdict) => format!(
                "{} (returns of the simulation and its multipliers within {within})",
                verdict.name()
            ),
            None => "none: no motion follows an orbit".to_owned(),
        },
    )]));
    blocks
}

/// A row for each impact of each orbit.
fn orbit_table<'a>(question: &ImpactEquation, found: &FoundOrbits) -> Block<'a> {
    let several = question.walls.len() > 1;
    let rows = found.orbits.iter().enumerate().flat_map(|(number, own)| {
        own.orbit.impacts.iter().enumerate().map(move |(index, impact)| {
            let first = |text: String| if index == 0 { text } else { String::new() };
            let wall = &question.walls[impact.wall].wall.gap;
            let mut row = vec![
                first((number + 1).to_string()),
                first(own.orbit.periods.to_string()),
                decimal(impact.speed),
                decimal(impact.phase),
            ];
            row.extend(several.then(|| format!("{wall} = 0")));
            row.push(first(kind_in_words(&own.orbit)));
            row
        })
    });
    let mut head = vec!["orbit", "n", "speed before", "phase"];
    head.extend(several.then_some("wall"));
    head.push("which is");
    Block::table(head, rows.collect::<Vec<_>>())
}

/// Stability in a word; an orbit that no motion follows is said to be so.
fn kind_in_words(orbit: &ImpactOrbit) -> String {
    let symmetric = if orbit.kind == OrbitKind::Symmetric { ", symmetric" } else { "" };
    match orbit.is_admissible() {
        true => format!("{}{symmetric}", orbit.stability.name()),
        false => format!("not physical{symmetric}"),
    }
}

/// The multipliers of each orbit beside those of the simulation.
fn multiplier_table<'a>(found: &FoundOrbits) -> Block<'a> {
    let rows = found.orbits.iter().enumerate().map(|(number, own)| {
        let judged = own.verdict.as_ref();
        let simulated = judged.and_then(|judged| judged.multipliers.as_ref());
        let errors = judged.map(|judged| judged.return_error).filter(|error| error.is_finite());
        vec![
            (number + 1).to_string(),
            pair(&own.orbit.multipliers),
            simulated.map_or("-".to_owned(), pair),
            errors.map_or("-".to_owned(), |error| {
                if error < 1e-9 { "< 1e-9".to_owned() } else { decimal(error) }
            }),
            verdict_in_words(own).to_owned(),
        ]
    });
    Block::table(
        ["orbit", "multipliers", "of the simulation", "return error", "verdict"],
        rows.collect::<Vec<_>>(),
    )
}

fn verdict_in_words(own: &JudgedImpactOrbit) -> &'static str {
    match (&own.verdict, own.orbit.is_admissible()) {
        (Some(verdict), _) => verdict.verdict.name(),
        (None, true) => "not followed",
        (None, false) => "-",
    }
}

/// Two multipliers in a cell.
fn pair([a, b]: &[Complex64; 2]) -> String {
    match a.im == 0.0 && b.im == 0.0 {
        true => format!("{}, {}", decimal(a.re), decimal(b.re)),
        false => format!("{} +- {}i", decimal(a.re), decimal(a.im.abs())),
    }
}

/// The place where an orbit is beyond a wall.
pub(crate) fn obstacle_in_words(question: &ImpactEquation, orbit: &ImpactOrbit) -> Option<String> {
    let obstacle = orbit.obstacle?;
    let first = orbit.impacts.first()?;
    let wall = &question.walls[obstacle.wall].wall.gap;
    Some(format!(
        "no motion follows the orbit of n = {} and the speed {}, which passes the wall {wall} = 0 at t = {}, {} after the impact",
        orbit.periods,
        decimal(first.speed),
        decimal(first.time + obstacle.after),
        decimal(obstacle.after)
    ))
}

/// The orbits along a parameter.
fn along<'a>(sweep: &OrbitSweep) -> Vec<Block<'a>> {
    let [from, to] = sweep.vary.range;
    let name = sweep.vary.name;
    let rows = sweep.branches.iter().flat_map(|branch| {
        ranges(branch)
            .into_iter()
            .map(|range| {
                let family = family_in_words(branch.family);
                let ends = |of: fn(&crate::orbits::BranchPoint) -> f64| {
                    let [first, last] =
                        [0, range.len() - 1].map(|index| decimal(of(&range[index])));
                    format!("{first} to {last}")
                };
                let is = match range[0].admissible {
                    true => range[0].stability.name(),
                    false => "not physical",
                };
                vec![family, ends(|own| own.parameter), ends(|own| own.speed), is.to_owned()]
            })
            .collect::<Vec<_>>()
    });
    let rows: Vec<Vec<String>> = rows.collect();
    let mut blocks = vec![Block::Heading(format!(
        "Orbits along {name} = {} to {}{}",
        decimal(from),
        decimal(to),
        values_in_words(&sweep.at)
    ))];
    match rows.is_empty() {
        true => {
            blocks.push(Block::Note("no orbit: nowhere is the speed real and positive".to_owned()))
        }
        false => {
            blocks.push(Block::table(["orbits", "parameter", "speed before", "which are"], rows))
        }
    }
    let rows = sweep.changes.iter().map(|own| {
        vec![
            own.change.name().replace('-', " "),
            family_in_words(own.family),
            decimal(own.parameter),
            own.speed.map_or("-".to_owned(), decimal),
        ]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    if !rows.is_empty() {
        blocks.push(Block::Heading("Where orbits change".to_owned()));
        blocks.push(Block::table(["change", "orbits", "parameter", "speed before"], rows));
    }
    blocks
}

/// The parts of a branch that are alike in stability and admissibility.
fn ranges(branch: &OrbitBranch) -> Vec<&[crate::orbits::BranchPoint]> {
    branch
        .points
        .chunk_by(|a, b| {
            a.admissible == b.admissible && (!a.admissible || a.stability == b.stability)
        })
        .collect()
}

/// A family of orbits in words: `n = 2`, `n = 1, symmetric`.
pub(crate) fn family_in_words(family: OrbitFamily) -> String {
    match (family.kind, family.wall) {
        (OrbitKind::Symmetric, _) => format!("n = {}, symmetric", family.periods),
        (_, 0) => format!("n = {}", family.periods),
        (_, wall) => format!("n = {}, wall {}", family.periods, wall + 1),
    }
}

/// The orbits over two parameters.
fn over_two<'a>(chart: &OrbitChart) -> Vec<Block<'a>> {
    let [columns, rows] = chart.size;
    let axes = [chart.across, chart.upwards].map(|own| {
        format!("{} = {} to {}", own.name, decimal(own.range[0]), decimal(own.range[1]))
    });
    let mut blocks = vec![Block::Heading(format!(
        "Orbits over {}, {}{}: {columns} by {rows} points",
        axes[0],
        axes[1],
        values_in_words(&chart.at)
    ))];
    let total = chart.points.len() as f64;
    let counts = chart.families.iter().enumerate().map(|(index, family)| {
        let part = |of: fn(&crate::orbits::ChartPoint, usize) -> u8| {
            let points = chart.points.iter().filter(|point| of(point, index) > 0).count();
            size_in_percent(points as f64 / total)
        };
        vec![
            family_in_words(*family),
            part(|point, index| point.orbits[index]),
            part(|point, index| point.stable[index]),
        ]
    });
    blocks.push(Block::table(["orbits", "exist on", "stable on"], counts.collect::<Vec<_>>()));
    let curves = chart.curves.iter().map(|curve| {
        let points = || curve.pieces.iter().flatten();
        let extent = |axis: usize| {
            let least = points().map(|point| point[axis]).fold(f64::INFINITY, f64::min);
            let greatest = points().map(|point| point[axis]).fold(f64::NEG_INFINITY, f64::max);
            format!("{} to {}", decimal(least), decimal(greatest))
        };
        vec![
            curve.change.name().replace('-', " "),
            family_in_words(curve.family),
            extent(0),
            extent(1),
        ]
    });
    let curves: Vec<Vec<String>> = curves.collect();
    if !curves.is_empty() {
        blocks.push(Block::Heading("Curves".to_owned()));
        blocks.push(Block::table(["curve", "orbits", "across", "upwards"], curves));
    }
    blocks
}

/// Conventions, and where the answer holds.
fn validity<'a>(report: &OrbitsReport<'a>, is_computed: bool) -> Vec<Block<'a>> {
    let mut notes: Vec<String> = Vec::new();
    for laws in report.laws {
        for note in &laws.validity {
            if !notes.contains(note) {
                notes.push(note.clone());
            }
        }
    }
    if is_computed {
        notes = vec![
            "speed before: relative to the wall, just before the impact".to_owned(),
            "not physical: the orbit of the closed form is beyond a wall between impacts".to_owned(),
            "closed forms of orbits with one impact in n periods; orbits with more impacts, and chaotic motions, are not shown".to_owned(),
        ];
    } else if let Some(found) = report.found {
        notes.truncate(1);
        notes.push("the simulation integrates the equation as it was typed, finds each impact as an event, and starts half a flight after an impact; its multipliers are central differences".to_owned());
        if found.impacts > 1 {
            notes.push(
                "searched by Newton's method from many phases and speeds: other orbits may exist"
                    .to_owned(),
            );
        }
        if found.orbits.iter().any(|own| own.orbit.stability == OrbitStability::Marginal) {
            notes.push("marginal: a multiplier on the unit circle, as without any loss; the linear terms do not decide".to_owned());
        }
    }
    let heading = Block::Heading("Validity".to_owned());
    std::iter::once(heading).chain(notes.into_iter().map(Block::Note)).collect()
}

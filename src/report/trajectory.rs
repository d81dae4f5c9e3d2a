//! A simulated motion: the equations, the numbers in them, the states, and the energy balance.

use std::borrow::Cow;

use super::{Block, Document, Heading};
use crate::decimal::{decimal, significant};
use crate::derivation::DerivationLine;
use crate::event::StateEvent;
use crate::expr::Expr;
use crate::symbol::Symbol;
use crate::system::{Integrator, PathEnd};
use crate::trajectory::{
    Basins, Crossing, DISPLACEMENT, EventOccurrence, Fate, Impact, LyapunovExponent,
    PoincareSection, SweptMotion, Trajectory, TrajectoryRequest, WallRecord, WallRest, in_words,
};
use crate::wall::Wall;

/// Largest number of listed times of sticking.
const MOST_HELD: usize = 6;

/// Largest number of listed states of a section.
const MOST_ON_SECTION: usize = 40;

/// Largest number of listed impacts.
const MOST_IMPACTS: usize = 20;

/// Number of rows of the table if no samples are requested.
const ROWS: u32 = 20;

/// Largest unaccounted part of the energy, or difference of two integrators relative to the largest
/// displacement, of a motion that is trusted.
pub const TRUSTED: f64 = 1e-6;

/// A motion to be reported.
#[derive(Clone, Copy, Debug)]
pub struct TrajectoryReport<'a> {
    /// The motion.
    pub motion: &'a Trajectory,
    /// The motion by the other integrator, if it was computed for verification.
    pub judge: Option<&'a Trajectory>,
    /// The times at which states are requested.
    pub samples: &'a [f64],
    /// The time until which the motion is known to six digits, if that is not its end
    /// ([`Trajectory::known_until`]).
    pub known_until: Option<f64>,
    /// The largest Lyapunov exponent, if it was asked for.
    pub lyapunov: Option<LyapunovExponent>,
}

/// The reason not to trust a motion that was followed to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Doubt {
    /// The part of the largest energy that is not accounted for.
    Energy(f64),
    /// The difference of the two integrators, over the largest displacement.
    Integrators(f64),
}

impl std::fmt::Display for Doubt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Energy(part) => write!(
                f,
                "{} of the largest energy is not accounted for: do not trust this motion",
                significant(*part, 2)
            ),
            Self::Integrators(difference) => write!(
                f,
                "the two integrators differ by {} of the largest displacement: do not trust this motion so far",
                significant(*difference, 2)
            ),
        }
    }
}

impl TrajectoryReport<'_> {
    /// The energy that is not accounted for, or the difference of two integrators, if either
    /// exceeds [`TRUSTED`]; `None` otherwise.
    pub fn doubt(&self) -> Option<Doubt> {
        let residual = self.motion.balance.as_ref().map(|balance| balance.residual);
        let difference = self.judge.map(|judge| self.motion.difference(judge));
        let is_doubtful = |part: &f64| *part > TRUSTED;
        let energy = residual.filter(is_doubtful).map(Doubt::Energy);
        energy.or_else(|| difference.filter(is_doubtful).map(Doubt::Integrators))
    }

    /// Whether the motion, and that of the other integrator, cover the whole duration, and there is
    /// no [doubt](Self::doubt).
    pub fn is_complete(&self) -> bool {
        let motions = [Some(self.motion), self.judge];
        motions.into_iter().flatten().all(Trajectory::is_complete) && self.doubt().is_none()
    }

    /// The times of the table: those requested, or equally spaced ones.
    pub fn times(&self) -> Vec<f64> {
        let end = self.motion.end();
        match self.samples.is_empty() {
            true => (0..=ROWS).map(|row| end * f64::from(row) / f64::from(ROWS)).collect(),
            false => self.samples.to_vec(),
        }
    }
}

/// The document of a motion.
///
/// ```
/// use lindstedt::Oscillator;
/// use lindstedt::report::TrajectoryReport;
/// use lindstedt::trajectory::TrajectoryRequest;
///
/// let mut course = TrajectoryRequest::of_equation(&Oscillator::parse("x'' + x = 0")?);
/// course.begin("x".into(), 1.0)?;
/// let motion = course.follow()?;
/// let report = TrajectoryReport { motion: &motion, judge: None, samples: &[1.0], known_until: None, lyapunov: None };
/// let text = lindstedt::export::text::document(&lindstedt::report::trajectory(&report), 120);
/// assert!(text.contains("0.540302"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn trajectory<'a>(report: &TrajectoryReport<'a>) -> Document<'a> {
    let motion = report.motion;
    let course = &motion.course;
    let mut sections = vec![course.equations.iter().map(equation).collect::<Vec<_>>()];
    let values = course.values.iter().map(|(name, value)| Block::Value {
        name: *name,
        value: *value,
        source: None,
    });
    let values: Vec<Block> = values.collect();
    if !values.is_empty() {
        sections.push(values);
    }
    sections.push(states(report));
    if let Some(section) = &course.section {
        sections.push(on_section(motion, section));
    }
    if !course.walls.is_empty() {
        sections.push(on_walls(motion));
    }
    if !course.events.is_empty() {
        sections.push(at_events(motion));
    }
    sections.push(account(report));
    Document { sections }
}

fn states<'a>(report: &TrajectoryReport<'a>) -> Vec<Block<'a>> {
    let motion = report.motion;
    let times = std::iter::once(Heading::from(("t", "$t$")));
    let names = motion.course.rates.states.iter().map(|name| name.name().into());
    let row = |time: f64| {
        let state = motion.states_at(time)?;
        Some(std::iter::once(time).chain(state).map(decimal).collect())
    };
    vec![Block::table(times.chain(names), report.times().into_iter().filter_map(row))]
}

/// The first states on the section.
fn on_section<'a>(motion: &Trajectory, section: &PoincareSection) -> Vec<Block<'a>> {
    let crossings = motion.crossings();
    let count = crossings.len();
    let mut words = format!(
        "{}: {count} state{}",
        section_in_words(section),
        if count == 1 { "" } else { "s" }
    );
    if motion.course.after > 0.0 {
        words.push_str(&format!(" from t = {} on", decimal(motion.course.after)));
    }
    match motion.touches().len() {
        0 => {}
        1 => words.push_str("; touched once, not crossed, which is no state"),
        touches => {
            words.push_str(&format!("; touched {touches} times, not crossed, which are no states"))
        }
    }
    if count > MOST_ON_SECTION {
        words.push_str(&format!("; the first {MOST_ON_SECTION}, all of them as CSV or JSON"));
    }
    let names = motion.course.rates.states.iter().map(|name| name.name());
    let row = |crossing: &Crossing| -> Vec<String> {
        let numbers = std::iter::once(&crossing.time).chain(&crossing.state);
        numbers.map(|number| decimal(*number)).collect()
    };
    let mut blocks = vec![Block::Heading(words)];
    if count > 0 {
        blocks.push(Block::table(
            std::iter::once("t").chain(names),
            crossings.iter().take(MOST_ON_SECTION).map(row),
        ));
    }
    blocks
}

/// The walls, the first impacts, and the rests.
fn on_walls<'a>(motion: &Trajectory) -> Vec<Block<'a>> {
    let walls = &motion.course.walls;
    let several = walls.len() > 1;
    let mut blocks: Vec<Block> = walls
        .iter()
        .enumerate()
        .map(|(index, wall)| Block::Note(wall_in_words(index, wall, several)))
        .collect();
    let WallRecord { impacts, rests, order_matters } = &motion.walls;
    let count = impacts.len();
    let mut words = format!("{count} impact{}", if count == 1 { "" } else { "s" });
    if count > MOST_IMPACTS {
        words.push_str(&format!("; the first {MOST_IMPACTS}, all of them as JSON"));
    }
    blocks.push(Block::Heading(words));
    let with_loss = impacts.iter().any(|impact| impact.loss.is_some());
    let mut head = vec!["t"];
    head.extend(several.then_some("wall"));
    head.extend(["gap closes at", "gap opens at"]);
    head.extend(with_loss.then_some("energy lost"));
    let row = |impact: &Impact| -> Vec<String> {
        let mut cells = vec![decimal(impact.time)];
        cells.extend(several.then(|| (impact.wall + 1).to_string()));
        cells.extend([impact.speed, impact.departure].map(decimal));
        cells.extend(with_loss.then(|| impact.loss.map_or_else(String::new, decimal)));
        cells
    };
    if count > 0 {
        blocks.push(Block::table(head, impacts.iter().take(MOST_IMPACTS).map(row)));
    }
    blocks
        .extend(rests.iter().take(MOST_HELD).map(|rest| Block::Note(rest_in_words(rest, several))));
    if rests.len() > MOST_HELD {
        blocks.push(Block::Note(format!("and {} rests more", rests.len() - MOST_HELD)));
    }
    blocks.extend(order_matters.map(|time| {
        Block::Note(format!(
            "at t = {} several walls are hit at once, and the order of the impacts matters: they are taken in the order of the walls",
            decimal(time)
        ))
    }));
    blocks
}

/// The events, and the first times at which they took place.
fn at_events<'a>(motion: &Trajectory) -> Vec<Block<'a>> {
    let course = &motion.course;
    let several = course.events.len() > 1;
    let mut blocks: Vec<Block> = course
        .events
        .iter()
        .enumerate()
        .map(|(index, event)| Block::Note(event_in_words(index, event, several)))
        .collect();
    let occurrences = &motion.events.occurrences;
    let count = occurrences.len();
    let mut words = format!("{count} event{}", if count == 1 { "" } else { "s" });
    if count > MOST_IMPACTS {
        words.push_str(&format!("; the first {MOST_IMPACTS}, all of them as JSON"));
    }
    blocks.push(Block::Heading(words));
    // The states that any event sets.
    let states = course.rates.states.iter().enumerate();
    let set: Vec<(usize, &Symbol)> = states
        .filter(|(_, state)| {
            course.events.iter().flat_map(|event| &event.assignments).any(|(own, _)| own == *state)
        })
        .collect();
    let with_loss = occurrences.iter().any(|event| event.loss.is_some());
    let mut head = vec!["t"];
    head.extend(several.then_some("event"));
    for (_, state) in &set {
        // The names of a table must have the lifetime of the program.
        head.extend(
            ["before", "behind"].map(|side| Symbol::new(&format!("{state} {side}")).name()),
        );
    }
    head.extend(with_loss.then_some("energy lost"));
    let row = |event: &EventOccurrence| -> Vec<String> {
        let mut cells = vec![decimal(event.time)];
        cells.extend(several.then(|| (event.event + 1).to_string()));
        for (index, _) in &set {
            cells.extend([&event.before, &event.after].map(|state| decimal(state[*index])));
        }
        cells.extend(with_loss.then(|| event.loss.map_or_else(String::new, decimal)));
        cells
    };
    if count > 0 {
        blocks.push(Block::table(head, occurrences.iter().take(MOST_IMPACTS).map(row)));
    }
    for index in 0..course.events.len() {
        if occurrences.iter().all(|event| event.event != index) {
            let number = if several { format!(" {}", index + 1) } else { String::new() };
            blocks.push(Block::Note(format!("event{number} does not take place")));
        }
    }
    blocks.extend(motion.events.order_matters.map(|time| {
        Block::Note(format!(
            "at t = {} several events take place at once, and their order matters: they are taken in the order in which they are given",
            decimal(time)
        ))
    }));
    blocks
}

/// An event in words.
pub(crate) fn event_in_words(index: usize, event: &StateEvent, several: bool) -> String {
    let number = if several { format!(" {}", index + 1) } else { String::new() };
    let set = event.assignments.iter().map(|(state, value)| format!("{state} = {value}"));
    let set = set.collect::<Vec<String>>().join(", ");
    format!("event{number} where {} sets {set}", event.condition())
}

/// A wall in words.
pub(crate) fn wall_in_words(index: usize, wall: &Wall, several: bool) -> String {
    let number = if several { format!(" {}", index + 1) } else { String::new() };
    format!("wall{number} at {} = 0, coefficient of restitution {}", wall.gap, wall.restitution)
}

/// A rest on a wall in words.
fn rest_in_words(rest: &WallRest, several: bool) -> String {
    let number = if several { format!(" {}", rest.wall + 1) } else { String::new() };
    let after = match rest.after_chatter {
        true => ", after infinitely many impacts, the time of which is summed in closed form",
        false => "",
    };
    format!(
        "rests on wall{number} from t = {} to {}{after}",
        decimal(rest.from),
        decimal(rest.until)
    )
}

/// The section in words.
pub(crate) fn section_in_words(section: &PoincareSection) -> String {
    match section {
        PoincareSection::Every(period) => format!("Section every {period}"),
        PoincareSection::Rising(expression) => {
            format!("Section where {expression} grows through zero")
        }
        PoincareSection::Impacts => "Section just before each impact".to_owned(),
        PoincareSection::Events => "Section just before each event".to_owned(),
    }
}

/// The document of many motions, a row each: the varied values, the end, the extremes and the
/// number of states on the section.
pub fn motion_sweep<'a>(sweep: &MotionSweep<'a>) -> Document<'a> {
    let course = sweep.course;
    let mut head: Vec<&str> = sweep.names.iter().map(|name| name.name()).collect();
    let extremes = course
        .coordinates
        .iter()
        .flat_map(|name| [format!("least {name}"), format!("greatest {name}")]);
    // The names of a table must have the lifetime of the program.
    head.extend(extremes.map(|name| Symbol::new(&name).name()));
    let on_section = course.section.is_some();
    if on_section {
        head.push("section");
    }
    let with_walls = !course.walls.is_empty();
    if with_walls {
        head.push("impacts");
    }
    let with_events = !course.events.is_empty();
    if with_events {
        head.push("events");
    }
    let rows = sweep.motions.iter().map(|motion| {
        let numbers = motion.values.iter().chain(motion.extremes.iter().flatten());
        let numbers = numbers.map(|value| decimal(*value));
        let counted = on_section.then(|| motion.crossings.len().to_string());
        let hits = with_walls.then(|| motion.impacts.to_string());
        let events = with_events.then(|| motion.events.to_string());
        numbers.chain(counted).chain(hits).chain(events).collect()
    });
    let mut last = sweep_notes(course, sweep.motions.len());
    let ended = sweep.motions.iter().filter(|motion| motion.reason != PathEnd::Reached).count();
    let basins = sweep.basins();
    if ended > 0 && basins.is_none() {
        last.push(Block::Note(format!("{ended} of them end early")));
    }
    let are_many = basins.is_some() && sweep.motions.len() > MOST_STARTS;
    let mut sections: Vec<Vec<Block>> = vec![course.equations.iter().map(equation).collect()];
    sections.extend((!are_many).then(|| vec![Block::table(head, rows)]));
    sections.push(last);
    sections.extend(basins.map(|basins| attractors(course, &basins)));
    Document { sections }
}

/// Largest number of starts whose motions are listed above their attractors.
pub const MOST_STARTS: usize = 100;

/// An equation of motion, `left = 0`.
fn equation(left: &Expr) -> Block<'static> {
    Block::Line(Cow::Owned(DerivationLine::equation(left.clone(), Expr::zero())))
}

/// The answer of a sweep of so many starts that their attractors alone are listed.
pub fn basin_sweep<'a>(sweep: &BasinSweep<'a>) -> Document<'a> {
    let course = sweep.course;
    Document {
        sections: vec![
            course.equations.iter().map(equation).collect(),
            sweep_notes(course, sweep.starts.len()),
            attractors(course, sweep.basins),
        ],
    }
}

/// The number of motions and their times, and the section.
fn sweep_notes(course: &TrajectoryRequest, motions: usize) -> Vec<Block<'static>> {
    let mut words = format!("{motions} motions to t = {}", decimal(course.duration));
    if course.after > 0.0 {
        words.push_str(&format!("; least and greatest from t = {} on", decimal(course.after)));
    }
    let section = course.section.as_ref().map(|section| Block::Note(section_in_words(section)));
    [Block::Note(words)].into_iter().chain(section).collect()
}

/// The attractors of motions from many starts, with how many of them settle on each.
fn attractors(course: &TrajectoryRequest, basins: &Basins) -> Vec<Block<'static>> {
    let mut head = vec!["attractor", "motions", "share", "states"];
    head.extend(course.rates.states.iter().map(|name| name.name()));
    let all = basins.fates.len().max(1) as f64;
    let rows = basins.attractors.iter().enumerate().map(|(index, attractor)| {
        let share = format!("{} %", significant(100.0 * attractor.motions as f64 / all, 3));
        let counts = [
            (index + 1).to_string(),
            attractor.motions.to_string(),
            share,
            attractor.states.len().to_string(),
        ];
        let lowest = attractor.states.first().into_iter().flatten();
        counts.into_iter().chain(lowest.map(|value| significant(*value, 6))).collect()
    });
    let mut blocks = match basins.attractors.is_empty() {
        true => vec![],
        false => vec![
            Block::Heading(
                "Attractors, with the number of their states on the section and the lowest"
                    .to_owned(),
            ),
            Block::table(head, rows),
        ],
    };
    for (fate, [one, several]) in [
        (
            Fate::Unsettled,
            [
                "does not settle on a cycle by the end: a later --until may tell",
                "do not settle on a cycle by the end: a later --until may tell",
            ],
        ),
        (Fate::Ended, ["ends early", "end early"]),
    ] {
        match basins.count(fate) {
            0 => {}
            1 => blocks.push(Block::Note(format!("1 motion {one}"))),
            count => blocks.push(Block::Note(format!("{count} motions {several}"))),
        }
    }
    blocks
}

/// Many motions to be reported.
#[derive(Clone, Copy, Debug)]
pub struct MotionSweep<'a> {
    /// The common initial value problem.
    pub course: &'a TrajectoryRequest,
    /// The names of the varied parameters.
    pub names: &'a [Symbol],
    /// The motions, the last name varying fastest.
    pub motions: &'a [SweptMotion],
}

/// The attractors of motions from many starts to be reported.
#[derive(Clone, Copy, Debug)]
pub struct BasinSweep<'a> {
    /// The common initial value problem.
    pub course: &'a TrajectoryRequest,
    /// The names of the two varied states of the start.
    pub names: [Symbol; 2],
    /// The starts, the last name varying fastest.
    pub starts: &'a [Vec<f64>],
    /// The attractors, and the fate of each start.
    pub basins: &'a Basins,
}

impl MotionSweep<'_> {
    /// The attractors on which the motions settle; `None` unless states of the start alone are varied, and the
    /// states are recorded on a section.
    pub fn basins(&self) -> Option<Basins> {
        let states = &self.course.rates.states;
        let are_starts = self.names.iter().all(|name| states.contains(name));
        (are_starts && self.course.section.is_some()).then(|| Basins::new(self.motions))
    }
}

fn account<'a>(report: &TrajectoryReport<'a>) -> Vec<Block<'a>> {
    let motion = report.motion;
    let mut facts = vec![(
        "followed by",
        match motion.integrator {
            Integrator::Taylor => "the Taylor series of its states".to_owned(),
            Integrator::RungeKutta => "Runge-Kutta".to_owned(),
        },
    )];
    facts.push(("until", format!("t = {}, {}", decimal(motion.end()), in_words(motion.reason()))));
    let held: Vec<String> = motion
        .sticking_intervals()
        .take(MOST_HELD)
        .map(|[from, until]| format!("{} to {}", decimal(from), decimal(until)))
        .collect();
    let more = motion.sticking_intervals().count().saturating_sub(MOST_HELD);
    if let Some(ratio) = &motion.course.static_friction {
        facts.push(("static friction", format!("{ratio} of the sliding one")));
    }
    if !held.is_empty() {
        let more = if more == 0 { String::new() } else { format!(", and {more} times more") };
        facts.push(("held by friction", format!("t = {}{more}", held.join(", "))));
    }
    if let Some(balance) = &motion.balance {
        facts.push(("energy at the start", decimal(balance.start)));
        facts.push(("energy at the end", decimal(balance.end)));
        facts.push((
            "work in between",
            match balance.works.as_slice() {
                [(name, work)] => format!("{} of {name}", decimal(*work)),
                _ => decimal(balance.work),
            },
        ));
        if balance.works.len() > 1 {
            let each: Vec<String> = balance
                .works
                .iter()
                .map(|(name, work)| format!("{} of {name}", decimal(*work)))
                .collect();
            facts.push(("which is", each.join(", ")));
        }
        facts.push((
            "unaccounted for",
            format!("{} of the largest", significant(balance.residual, 2)),
        ));
    }
    let unknown: Vec<String> =
        motion.course.missing_for_energy().iter().map(|name| format!("`{name}`")).collect();
    if !unknown.is_empty() {
        facts.push((
            "energy",
            format!(
                "not accounted for without a value for {}, which cancels in the equations of motion",
                unknown.join(", ")
            ),
        ));
    }
    if let Some(known) = report.known_until {
        let beyond = match motion.course.section {
            Some(_) => "; the section beyond is that of motions nearby",
            None => "",
        };
        let why = format!("then a start displaced by {DISPLACEMENT:e} of it is elsewhere{beyond}");
        facts.push(("six digits hold", format!("until t = {}, {why}", decimal(known))));
    }
    if let Some(LyapunovExponent { value, error, from }) = report.lyapunov {
        facts.push((
            "Lyapunov exponent",
            format!(
                "{} with a standard error of {}, the largest, from t = {} on",
                significant(value, 3),
                significant(error, 2),
                decimal(from)
            ),
        ));
    }
    if let Some(judge) = report.judge {
        let apart = significant(motion.difference(judge), 2);
        facts.push(("other integrator", format!("differs by {apart} of the largest displacement")));
    }
    vec![Block::Facts(facts)]
}

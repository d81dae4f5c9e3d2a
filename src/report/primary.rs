//! The main mass with its damper: its parameters, the events, the energy balance, and the effect of
//! the damper.

use super::trajectory::{Doubt, TRUSTED};
use super::{Block, Document, cell, materials, percent};
use crate::decimal::{decimal, significant};
use crate::impact::Units;
use crate::impact::primary::{Alone, NEARBY, PrimaryMotion, PrimaryParameter, PrimaryRow};
use crate::impact::sweep::{Axis, grid_values};
use crate::symbol::Symbol;

/// Largest number of listed impacts.
const MOST_IMPACTS: usize = 12;

/// A motion of main mass and pendulum to be reported.
#[derive(Clone, Copy, Debug)]
pub struct PrimaryReport<'a> {
    /// The motion.
    pub motion: &'a PrimaryMotion,
    /// The units of the numbers.
    pub units: &'a Units,
    /// The times at which states are requested, in units of 1/omega.
    pub samples: &'a [f64],
    /// The same motion by integration, if it was followed by closed forms.
    pub judge: Option<&'a PrimaryMotion>,
    /// The least and the greatest rest time of starts nearby, if it was followed by closed forms and
    /// they rest.
    pub nearby: Option<[f64; 2]>,
}

impl PrimaryReport<'_> {
    /// The energy that is not accounted for, if it exceeds [`TRUSTED`]; `None` otherwise, and for a
    /// chain, which is judged by its integration.
    pub fn doubt(&self) -> Option<Doubt> {
        let residual = self.motion.energy.residual;
        (residual > TRUSTED && !self.motion.by_chain).then_some(Doubt::Energy(residual))
    }

    /// Whether the motion covers the whole duration, and its energy is accounted for.
    pub fn is_complete(&self) -> bool {
        self.motion.is_complete() && self.doubt().is_none()
    }
}

/// The document of a motion.
///
/// ```
/// use lindstedt::impact::primary::simulate_primary;
/// use lindstedt::problem::Problem;
/// use lindstedt::report::PrimaryReport;
///
/// let file: Problem = "[primary]\nmass = 0.56\nstiffness = 80\ndisplacement = 0.02\n[run]\nduration = 20".parse()?;
/// let asked = file.primary_case(&[])?;
/// let motion = simulate_primary(asked.case, &asked.settings)?;
/// let report = PrimaryReport { motion: &motion, units: &asked.units, samples: &[], judge: None, nearby: None };
/// let text = lindstedt::export::text::document(&lindstedt::report::primary(&report), 120);
/// assert!(text.contains("damper locked"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn primary<'a>(report: &PrimaryReport<'a>) -> Document<'a> {
    let mut sections = vec![
        vec![
            Block::Heading("Main mass on spring and dashpot, with the pendulum and its barriers".to_owned()),
            Block::QuestionAsTyped("(R + 1)*y'' + x''*cos(x) - x'^2*sin(x) + delta*y' + kappa*y = f*sin(eta*t)"),
            Block::QuestionAsTyped(match (report.motion.case.model.left, report.motion.case.model.right) {
                (Some(_), None) => {
                    "x'' + y''*cos(x) + sin(x) + 2*zeta*x' + alpha*sgn(x') - (gamma - mu*x')*(xc - x)^(3/2)*H(xc - x) = 0"
                }
                _ => {
                    "x'' + y''*cos(x) + sin(x) + 2*zeta*x' + alpha*sgn(x') + (gamma + mu*x')*(x - xc)^(3/2)*H(x - xc) = 0"
                }
            }),
            Block::Note(
                "x: angle, rad; y: displacement of the main mass over L; t in units of 1/omega, omega^2 = g/L"
                    .to_owned(),
            ),
        ],
        values(report),
        impacts(report),
        energy(report),
        rest_times(report),
    ];
    if report.motion.by_chain {
        sections.push(closed_forms(report));
    }
    if !report.samples.is_empty() {
        sections.push(samples(report));
    }
    Document { sections }
}

fn values<'a>(report: &PrimaryReport<'a>) -> Vec<Block<'a>> {
    let case = &report.motion.case;
    let (primary, model) = (&case.primary, &case.model);
    let named = [
        ("R", primary.mass, "M/m"),
        ("kappa", primary.stiffness, "k L/(m g)"),
        ("delta", primary.damping, "(c/m) sqrt(L/g)"),
        ("f", primary.force, "F/(m g)"),
        ("eta", primary.frequency, "Omega sqrt(L/g)"),
        ("gamma", model.gamma, "stiffness of the contact"),
        ("mu", model.mu, "damping of the contact"),
        ("zeta", model.zeta, "damping of the pendulum"),
        ("alpha", model.alpha, "dry friction of the pendulum"),
    ];
    let value = |(name, value, source): (&str, f64, &'static str)| Block::Value {
        name: Symbol::new(name),
        value,
        source: Some(source),
    };
    let always = ["R", "kappa", "gamma"];
    let given = named.into_iter().filter(|(name, value, _)| *value != 0.0 || always.contains(name));
    let mut blocks: Vec<Block> = given.map(value).collect();
    let places = [model.left, model.right].into_iter().flatten().map(decimal);
    let places: Vec<String> = places.collect();
    if !places.is_empty() {
        blocks.push(Block::Note(format!(
            "barriers that move with the main mass, at x = {}",
            places.join(" and ")
        )));
    }
    blocks.push(Block::Note(format!(
        "one unit of time is {} s, one of y {} m",
        decimal(report.units.time()),
        decimal(report.units.length)
    )));
    blocks
}

fn impacts<'a>(report: &PrimaryReport<'a>) -> Vec<Block<'a>> {
    let impacts = &report.motion.impacts;
    let count = impacts.len();
    let mut blocks = vec![Block::Heading(match count {
        0 => "No impact".to_owned(),
        1 => "One impact".to_owned(),
        _ if count > MOST_IMPACTS => format!("{count} impacts, the first {MOST_IMPACTS} of them"),
        _ => format!("{count} impacts"),
    })];
    let [x, ..] = report.motion.case.start;
    if let Some((side, depth)) = report.motion.case.model.depth(x) {
        blocks.push(Block::Note(format!(
            "the motion starts inside the {} barrier, {} deep: the first impact has no touch",
            side.name(),
            decimal(depth)
        )));
    }
    let or_none = |value: Option<f64>| value.map_or_else(String::new, decimal);
    let row = |impact: &crate::impact::primary::PrimaryImpact| {
        vec![
            decimal(impact.entry_time),
            or_none(impact.exit_time.map(|exit| exit - impact.entry_time)),
            impact.side.name().to_owned(),
            decimal(impact.speed_in),
            or_none(impact.speed_out),
            decimal(impact.penetration),
            decimal(impact.energy_lost),
        ]
    };
    if count > 0 {
        blocks.push(Block::table(
            ["touch", "duration", "side", "speed in", "speed out", "depth", "energy lost"],
            impacts.iter().take(MOST_IMPACTS).map(row),
        ));
    }
    blocks
}

fn energy<'a>(report: &PrimaryReport<'a>) -> Vec<Block<'a>> {
    let energy = &report.motion.energy;
    let mut facts =
        vec![("at the start", decimal(energy.start)), ("at the end", decimal(energy.end))];
    for (name, value) in [
        ("damping of the pendulum", energy.viscous),
        ("dry friction", energy.friction),
        ("contacts", energy.contact),
        ("dashpot of the main mass", energy.dashpot),
        ("put in by the force", energy.force),
    ] {
        if value != 0.0 {
            facts.push((name, decimal(value)));
        }
    }
    facts.push(("unaccounted for", format!("{} of the largest", significant(energy.residual, 2))));
    vec![Block::Heading("Energy, in units of m g L".to_owned()), Block::Facts(facts)]
}

fn rest_times<'a>(report: &PrimaryReport<'a>) -> Vec<Block<'a>> {
    let motion = report.motion;
    let others = motion.case.primary.undamped_and_locked();
    let seconds = |time: f64| decimal(time * report.units.time());
    let driven = motion.case.primary.force != 0.0;
    let alone = |name: &str, alone: &Alone| {
        let words = match (alone.rest_time, alone.amplitude) {
            (Some(time), _) => [decimal(time), seconds(time)],
            (None, Some(amplitude)) => {
                [decimal(amplitude), decimal(amplitude * report.units.length)]
            }
            (None, None) if alone.frequency == 0.0 => ["creeps".to_owned(), String::new()],
            (None, None) => ["none".to_owned(), String::new()],
        };
        let [first, second] = words;
        vec![name.to_owned(), first, second]
    };
    let own = match (driven, motion.rest_time()) {
        (true, _) => {
            let amplitude = motion.largest_since(0.75 * motion.end);
            [
                "with its damper".to_owned(),
                decimal(amplitude),
                decimal(amplitude * report.units.length),
            ]
        }
        (false, Ok(time)) => ["with its damper".to_owned(), decimal(time), seconds(time)],
        (false, Err(_)) => ["with its damper".to_owned(), "none".to_owned(), String::new()],
    };
    let (heading, head) = match driven {
        true => (
            "Amplitude of the main mass in the long run; with its damper the largest |y| in the last quarter of the run",
            ["main mass", "over L", "m"],
        ),
        false => (
            "When the main mass has come to rest: its envelope is down to 10 %",
            ["main mass", "1/omega", "s"],
        ),
    };
    let mut blocks = vec![
        Block::Heading(heading.to_owned()),
        Block::table(
            head,
            vec![
                own.into(),
                alone("damper locked", &others.locked),
                alone("without", &others.without),
            ],
        ),
    ];
    if let (false, Err(reason)) = (driven, motion.rest_time()) {
        blocks.push(Block::Note(format!("with its damper: {reason}")));
    }
    if !driven && motion.case.primary.damping == 0.0 {
        blocks.push(Block::Note(
            "without a dashpot a main mass alone never comes to rest".to_owned(),
        ));
    }
    blocks
}

/// The phases of a chain, and how far it is from its integration.
fn closed_forms<'a>(report: &PrimaryReport<'a>) -> Vec<Block<'a>> {
    let motion = report.motion;
    let phases = motion.phase_starts().count();
    let mut blocks = vec![
        Block::Heading("By a chain of closed forms".to_owned()),
        Block::Note(format!(
            "{phases} phases, {} of them integrated for want of a closed form",
            motion.integrated
        )),
    ];
    let Some(judge) = report.judge else { return blocks };
    let driven = motion.case.primary.force != 0.0;
    let time = |motion: &PrimaryMotion| motion.rest_time().ok().filter(|_| !driven);
    let amplitude = |motion: &PrimaryMotion| motion.largest_since(0.75 * motion.end);
    let error = |found: f64, truth: f64| match truth == 0.0 {
        true => String::new(),
        false => percent(found / truth - 1.0),
    };
    let mut rows = vec![];
    let (found, truth) = (time(motion), time(judge));
    if found.is_some() || truth.is_some() {
        let off = found.zip(truth).map_or_else(String::new, |(found, truth)| error(found, truth));
        rows.push(vec!["rest time, 1/omega".to_owned(), cell(found), cell(truth), off]);
    }
    let (found, truth) = (amplitude(motion), amplitude(judge));
    let name = "largest |y| in the last quarter, over L";
    rows.push(vec![name.to_owned(), decimal(found), decimal(truth), error(found, truth)]);
    let [found, truth] = [motion, judge].map(|motion| motion.impacts.len());
    rows.push(vec!["impacts".to_owned(), found.to_string(), truth.to_string(), String::new()]);
    blocks.push(Block::table(["", "closed forms", "integration", "error"], rows));
    if time(motion).is_some() {
        blocks.push(Block::Sentence(validity(report.nearby)));
    }
    blocks
}

/// Whether a rest time by closed forms can be relied upon, by those of starts nearby.
fn validity(nearby: Option<[f64; 2]>) -> String {
    let part = significant(100.0 * NEARBY, 1);
    let Some([least, greatest]) = nearby else {
        return format!(
            "Not all starts {part} % smaller and larger rest within the run: closed forms cannot give this rest time; integrate \
             instead, without --chain."
        );
    };
    let [from, to] = [least, greatest].map(|rest| significant(rest, 4));
    match rests_as_nearby(nearby) {
        true => format!(
            "Starts {part} % smaller and larger rest within {} of each other.",
            materials::percent(greatest / least - 1.0)
        ),
        false => format!(
            "Starts {part} % smaller and larger rest between {from} and {to}: each impact decides when the next one is, and closed \
             forms cannot give this rest time; integrate instead, without --chain."
        ),
    }
}

/// The largest spread of rest times of starts nearby with which closed forms give them.
pub(super) const MOST_SPREAD: f64 = 0.005;

/// Whether starts nearby rest at times so near each other that closed forms give them.
pub(super) fn rests_as_nearby(nearby: Option<[f64; 2]>) -> bool {
    nearby.is_some_and(|[least, greatest]| greatest <= (1.0 + MOST_SPREAD) * least)
}

fn samples<'a>(report: &PrimaryReport<'a>) -> Vec<Block<'a>> {
    let row = |time: &f64| {
        let state = report.motion.state_at(*time)?;
        Some([*time, state.x, state.velocity, state.y, state.speed].map(decimal).into())
    };
    vec![Block::table(["t", "x", "x'", "y", "y'"], report.samples.iter().filter_map(row))]
}

/// A sweep of a main mass to be reported.
#[derive(Clone, Copy, Debug)]
pub struct PrimarySweepReport<'a> {
    /// The values that are swept; the last axis varies fastest.
    pub axes: &'a [Axis],
    /// The parameters of the axes, in the same order.
    pub parameters: &'a [PrimaryParameter],
    /// A row for each motion.
    pub rows: &'a [PrimaryRow],
    /// The units of each motion, which depend on the pendulum.
    pub units: &'a [Units],
}

impl PrimarySweepReport<'_> {
    /// The values of the parameters of a row.
    pub fn values(&self, row: usize) -> Vec<f64> {
        grid_values(self.axes, row)
    }

    /// Whether a force drives any of the motions: then the report shows their amplitudes in the
    /// long run, otherwise their rest times.
    pub fn is_driven(&self) -> bool {
        self.rows.iter().any(PrimaryRow::is_driven)
    }
}

/// The document of a sweep.
///
/// ```
/// use lindstedt::impact::primary::sweep_primary;
/// use lindstedt::impact::sweep::Axis;
/// use lindstedt::problem::Problem;
/// use lindstedt::report::PrimarySweepReport;
///
/// let file: Problem = "[primary]\nmass = 0.56\nstiffness = 80\nforce = 0.01\ndamping = 0.5\n[run]\nduration = 20".parse()?;
/// let (axis, parameter): (Axis, _) = ("frequency=9:11:2".parse()?, "frequency".parse()?);
/// let asked: Result<Vec<_>, _> = axis.values().iter().map(|value| file.primary_case(&[(parameter, *value)])).collect();
/// let (motions, units): (Vec<_>, Vec<_>) = asked?.into_iter().map(|asked| ((asked.case, asked.settings), asked.units)).unzip();
/// let rows = sweep_primary(&motions, |_| ()).map_err(|(_, error)| error)?;
/// let report = PrimarySweepReport { axes: &[axis], parameters: &[parameter], rows: &rows, units: &units };
/// let text = lindstedt::export::text::document(&lindstedt::report::primary_sweep(&report), 120);
/// assert_eq!(text.lines().filter(|line| line.contains('.')).count(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn primary_sweep<'a>(report: &PrimarySweepReport) -> Document<'a> {
    let driven = report.is_driven();
    let row = |(number, (row, units)): (usize, (&PrimaryRow, &Units))| {
        let (length, time, begun) = (units.length, units.time(), row.is_begun());
        let others = [row.others.locked, row.others.without];
        let results = match driven {
            true => [begun.then_some(row.amplitude), others[0].amplitude, others[1].amplitude]
                .map(|value| value.map(|value| value * length)),
            false => [row.rest_time.ok(), others[0].rest_time, others[1].rest_time]
                .map(|value| value.map(|value| value * time)),
        };
        let impacts = if driven { row.impacts } else { row.all_impacts };
        let mut cells: Vec<String> = report.values(number).into_iter().map(decimal).collect();
        cells.extend(results.map(cell));
        cells.push(match begun {
            true => impacts.to_string(),
            false => "-".to_owned(),
        });
        cells
    };
    let names = report.parameters.iter().map(|parameter| parameter.name());
    let results = ["with its damper", "damper locked", "without", "impacts"];
    let head = names.chain(results);
    let meanings = report.parameters.iter().map(|parameter| {
        let unit = parameter.unit();
        let comma = if unit.is_empty() { "" } else { ", " };
        Block::Note(format!("{}: {}{comma}{unit}", parameter.name(), parameter.meaning()))
    });
    let heading = match driven {
        true => {
            "Amplitude of the main mass in the long run, m; impacts in the last quarter of the run"
        }
        false => {
            "When the main mass has come to rest, s: its envelope is down to 10 %; impacts in the whole run"
        }
    };
    let mut blocks = vec![Block::Heading(heading.to_owned())];
    blocks.extend(meanings);
    blocks.push(Block::table(head, report.rows.iter().zip(report.units).enumerate().map(row)));
    Document { sections: vec![blocks] }
}

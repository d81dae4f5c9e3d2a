//! Equation (6) compared with Coulomb's law: Table 1 of the paper, the value of pi behind its
//! digits, and a swing near rest.

use super::{Block, Document};
use crate::audit::paper::{FrictionTable, TableRow};
use crate::decimal::{decimal, significant};
use crate::impact::NoRest;
use crate::impact::friction::{Creep, FrictionStudy, NearRest};

/// The document of a study of friction.
///
/// ```
/// use lindstedt::impact::friction::{FrictionSetup, study};
///
/// let study = study(FrictionSetup::default())?;
/// let document = lindstedt::report::friction(&study);
/// assert!(lindstedt::export::text::document(&document, 120).contains("by pi = 3.14"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn friction(study: &FrictionStudy) -> Document<'_> {
    let alpha = study.setup.alpha;
    let near_rest = &study.near_rest;
    let table = FrictionTable::from_study(study);
    Document {
        sections: vec![
            vec![
                Block::QuestionAsTyped("x'' + alpha*sgn(x') + sin(x) = 0"),
                Block::Note("the paper's equation (6): sgn(x') ~ (2/pi)*atan(100*x')".to_owned()),
            ],
            speeds(&table),
            readings(&table),
            first_cycle(alpha, study.setup.amplitude, near_rest),
            stop(alpha, near_rest),
            creep(alpha, &near_rest.creep),
            rest_times(near_rest),
        ],
    }
}

/// A share of one in per cent.
fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 4))
}

fn speeds(table: &FrictionTable) -> Vec<Block<'static>> {
    let row = |row: &TableRow| {
        let [value, error, treatment] = match row.printed {
            Some([value, error]) => [
                value.printed.to_owned(),
                error.printed.to_owned(),
                match value.treatment() == error.treatment() {
                    true => value.treatment().to_owned(),
                    false => format!("{}, {}", value.treatment(), error.treatment()),
                },
            ],
            None => Default::default(),
        };
        vec![
            decimal(row.laws.speed),
            decimal(row.laws.sign),
            format!("{:.6}", row.laws.arctangent),
            format!("{:.6}", row.laws.error),
            value,
            error,
            treatment,
        ]
    };
    vec![
        Block::Heading(format!(
            "Table 1 of the paper, and how its digits come out by pi = {}",
            table.best().name
        )),
        Block::table([
                ("x'", "$\\dot{x}$"),
                ("sgn", "sgn"),
                ("arctangent", "$(2/\\pi) \\arctan 100\\dot{x}$"),
                ("error, %", "error in \\%"),
                ("printed", "printed"),
                ("printed, %", "printed, in \\%"),
                ("digits", "digits"),
            ], table.rows.iter().map(row)),
        Block::Note(
            "digits: how the printed value and the printed error come out, rounded, cut off, or either way".to_owned(),
        ),
    ]
}

fn readings(table: &FrictionTable) -> Vec<Block<'static>> {
    let rows = table.readings.iter().map(|reading| {
        let counts = [reading.rounded, reading.cut, reading.either].map(|count| count.to_string());
        [&[reading.name.to_owned()], &counts[..]].concat()
    });
    let best = table.best();
    let range = match table.pi_range {
        Some([least, greatest]) => format!(
            "all of them come out, rounded or cut, with any pi from {} to {}",
            significant(least, 9),
            significant(greatest, 9)
        ),
        None => "no value of pi makes all of them come out".to_owned(),
    };
    let mut blocks = vec![
        Block::Heading(format!(
            "The {} printed entries that come out, by the value of pi",
            table.entries()
        )),
        Block::table(
            [("pi", "$\\pi$"), ("rounded", "rounded"), ("cut", "cut"), ("either", "either")],
            rows,
        ),
        Block::Note(range),
    ];
    if let Some(speed) = best.exceeds_from() {
        blocks.push(Block::Note(format!(
            "by pi = {} the arctangent exceeds 1 beyond |x'| = {} and tends to {}",
            best.name,
            decimal(speed),
            decimal(best.limit())
        )));
    }
    let worst = |row: &&TableRow| row.printed.is_some() && row.laws.speed != 0.0;
    if let Some(row) =
        table.rows.iter().filter(worst).max_by(|a, b| a.laws.speed.total_cmp(&b.laws.speed))
        && let Some([_, error]) = row.printed
    {
        blocks.push(Block::Note(format!(
            "true errors fall as 2/(100*pi*x'): at {} it is {} %, printed as {} %",
            decimal(row.laws.speed),
            decimal(row.laws.error),
            error.printed
        )));
    }
    blocks
}

fn first_cycle(alpha: f64, amplitude: f64, near_rest: &NearRest) -> Vec<Block<'static>> {
    let cycle = near_rest.first_cycle;
    let entries = [
        ("largest error of the force", "100 % of alpha, wherever the motion turns back".to_owned()),
        ("error above 1 %", format!("{} of the time", percent(cycle.over_one_percent))),
        ("error above 10 %", format!("{} of the time", percent(cycle.over_ten_percent))),
        ("work over that of sgn", decimal(cycle.work_share)),
        (
            "the same by formula",
            format!(
                "{}   (sqrt(1 + k^2) - 1)/k, k = 100 times the greatest speed",
                decimal(cycle.work_share_formula)
            ),
        ),
    ];
    vec![
        Block::Heading(format!(
            "First cycle by the arctangent, released at x = {}, alpha = {}, until t = {}",
            decimal(-amplitude),
            decimal(alpha),
            decimal(cycle.until)
        )),
        Block::Facts(entries.into()),
    ]
}

fn stop(alpha: f64, near_rest: &NearRest) -> Vec<Block<'static>> {
    let stop = near_rest.stop;
    let [x, velocity] = near_rest.meanwhile;
    let entries = [
        ("time", decimal(stop.t)),
        ("place", format!("{}   after {} half swings", decimal(stop.x), near_rest.half_swings)),
        (
            "sin of it",
            format!("{}, no more than alpha = {}", decimal(stop.x.sin().abs()), decimal(alpha)),
        ),
        ("the arctangent then", format!("x = {}, x' = {}", decimal(x), significant(velocity, 4))),
    ];
    vec![Block::Heading("Coulomb's law stops it for good".to_owned()), Block::Facts(entries.into())]
}

fn creep(alpha: f64, creep: &Creep) -> Vec<Block<'static>> {
    let words = match creep.creeps {
        true => "the arctangent never holds it: from rest at that place it creeps to zero",
        false => "the arctangent never holds it: from rest at that place it goes on swinging",
    };
    let linear = match creep.creeps {
        true => "(c - sqrt(c^2 - 4))/2",
        false => "c/2",
    };
    let mut entries = vec![
        ("damping near rest", format!("c = 200*alpha/pi = {}", decimal(creep.damping))),
        ("rate of the linear equation", format!("{}   {linear}", decimal(creep.rate_linear))),
        (
            "rate of the simulation",
            creep.rate.map_or("none: it is at rest there".to_owned(), decimal),
        ),
    ];
    if let Some(rate) = creep.rate_overdamped {
        entries.insert(1, ("rate without inertia", format!("{}   pi/(200*alpha)", decimal(rate))));
    }
    let mut head =
        vec![("t", "$t$"), ("x, Coulomb", "$x$, Coulomb"), ("x, arctangent", "$x$, arctangent")];
    if creep.creeps {
        head.push(("formula", "formula"));
    }
    let held = creep.motion.start.x;
    let rows = creep.samples.iter().map(|sample| {
        let row = [Some(sample.t), Some(held), Some(sample.x), sample.formula];
        row.into_iter().flatten().map(decimal).collect()
    });
    let mut blocks = vec![
        Block::Heading(format!("Near rest, alpha = {}: {words}", decimal(alpha))),
        Block::Facts(entries),
        Block::table(head, rows),
    ];
    if creep.creeps {
        blocks.push(Block::Note(
            "formula: without inertia y = sin(pi*sin(x)/(2*alpha)) falls as y' = -pi*cos(x)/(200*alpha)*y".to_owned(),
        ));
    }
    blocks
}

fn rest_times(near_rest: &NearRest) -> Vec<Block<'static>> {
    let times = near_rest.rest_times;
    let written = |time: Result<f64, NoRest>| match time {
        Ok(time) => decimal(time),
        Err(reason) => format!("none: {reason}"),
    };
    let mut entries =
        vec![("Coulomb's law", written(times.coulomb)), ("arctangent", written(times.arctangent))];
    if let (Some(difference), Ok(time)) = (times.difference(), times.coulomb) {
        entries.push((
            "difference",
            format!("{}, {}", decimal(difference), percent(difference / time)),
        ));
    }
    vec![
        Block::Heading(
            "Rest time (10 % of the amplitude) on the paper's damper, with this friction alone"
                .to_owned(),
        ),
        Block::Facts(entries),
    ]
}

//! A motion in numbers: the equations, the numbers in them, the states, and where the energy went.

use std::borrow::Cow;

use super::{Block, Document, Heading};
use crate::decimal::{decimal, significant};
use crate::derivation::Line;
use crate::expr::Expr;
use crate::system::Integrator;
use crate::trajectory::{Trajectory, in_words};

/// The most times of rest that are listed.
const MOST_HELD: usize = 6;

/// The rows of the table where no samples are asked for.
const ROWS: u32 = 20;

/// A motion to be reported.
#[derive(Clone, Copy, Debug)]
pub struct TrajectoryReport<'a> {
    /// The motion.
    pub motion: &'a Trajectory,
    /// The same by the other integrator, where it is judged.
    pub judge: Option<&'a Trajectory>,
    /// The times at which states are asked for.
    pub samples: &'a [f64],
}

impl TrajectoryReport<'_> {
    /// The times of the table: those asked for, or equally spaced ones.
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
/// use lindstedt::trajectory::Course;
///
/// let mut course = Course::of_equation(&Oscillator::parse("x'' + x = 0")?);
/// course.begin("x".into(), 1.0)?;
/// let motion = course.follow()?;
/// let report = TrajectoryReport { motion: &motion, judge: None, samples: &[1.0] };
/// let text = lindstedt::export::text::document(&lindstedt::report::trajectory(&report), 120);
/// assert!(text.contains("0.540302"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn trajectory<'a>(report: &TrajectoryReport<'a>) -> Document<'a> {
    let motion = report.motion;
    let course = &motion.course;
    let equation = |left: &Expr| Block::Line(Cow::Owned(Line::equation(left.clone(), Expr::zero())));
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
    sections.push(account(report));
    Document { sections }
}

fn states<'a>(report: &TrajectoryReport<'a>) -> Vec<Block<'a>> {
    let motion = report.motion;
    let times = std::iter::once(Heading {
        text: "t",
        latex: "$t$",
    });
    let names = motion.course.rates.states.iter().map(|name| Heading {
        text: name.name(),
        latex: name.name(),
    });
    let row = |time: f64| {
        let state = motion.at(time)?;
        Some(std::iter::once(time).chain(state).map(decimal).collect())
    };
    vec![Block::Table {
        head: times.chain(names).collect(),
        rows: report.times().into_iter().filter_map(row).collect(),
    }]
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
    facts.push((
        "until",
        format!("t = {}, {}", decimal(motion.end()), in_words(motion.reason())),
    ));
    let held: Vec<String> = motion
        .held()
        .take(MOST_HELD)
        .map(|[from, until]| format!("{} to {}", decimal(from), decimal(until)))
        .collect();
    let more = motion.held().count().saturating_sub(MOST_HELD);
    if !held.is_empty() {
        let more = if more == 0 {
            String::new()
        } else {
            format!(", and {more} times more")
        };
        facts.push(("held by friction", format!("t = {}{more}", held.join(", "))));
    }
    if let Some(balance) = motion.balance {
        facts.push(("energy at the start", decimal(balance.start)));
        facts.push(("energy at the end", decimal(balance.end)));
        facts.push(("work in between", decimal(balance.work)));
        facts.push((
            "unaccounted for",
            format!("{} of the largest", significant(balance.residual, 2)),
        ));
    }
    if let Some(judge) = report.judge {
        let apart = significant(motion.difference(judge), 2);
        facts.push((
            "other integrator",
            format!("differs by {apart} of the largest displacement"),
        ));
    }
    vec![Block::Facts(facts)]
}

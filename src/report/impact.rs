//! An impact: what was asked, the law of the free swing, the phases by either speed of contact, and the numbers beside
//! Runge-Kutta.

use super::{Block, Document};
use crate::decimal::decimal;
use crate::expr::Expr;
use crate::impact::{ContactSpeed, Impact, ThreePhases};

/// The document of an impact.
///
/// ```
/// use lindstedt::impact::{Setup, solve};
///
/// let impact = solve(Setup { stiffness: 1e6, ..Setup::default() })?;
/// let document = lindstedt::report::impact(&impact, 0.01);
/// assert!(lindstedt::export::text::document(&document, 80).contains("penetration"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn impact(impact: &Impact, tolerance: f64) -> Document<'_> {
    let setup = &impact.setup;
    let value = |name: &str, value, source| Block::Value {
        name: name.into(),
        value,
        source,
    };
    let asked = vec![
        value("A", setup.amplitude, None),
        value("xc", setup.barrier, None),
        value("gamma", setup.stiffness, Some(setup.stiffness_source.as_str())),
    ];
    let start = "x(0) = -A, x'(0) = 0: released from rest, towards a barrier at xc";
    Document {
        sections: vec![
            vec![
                Block::QuestionAsTyped(&impact.equation),
                Block::Heading(start.to_owned()),
            ],
            asked,
            free_swing(impact),
            phases(impact, &impact.paper),
            phases(impact, &impact.energy),
            judged(impact, tolerance),
        ],
    }
}

fn free_swing(impact: &Impact) -> Vec<Block<'_>> {
    let swing = &impact.free_swing;
    let heading = format!(
        "The law of the free swing, {} to order {} in A",
        swing.method.title(),
        swing.order
    );
    let mut blocks = vec![Block::Heading(heading), Block::Detail(swing.equation.to_string())];
    if let Some(squared) = swing.law.frequency_squared() {
        let omega = Expr::symbol("omega");
        blocks.push(Block::Law {
            left: &omega * &omega,
            right: swing.ordered(squared),
        });
    }
    blocks.push(Block::Detail(format!(
        "omega   = {}   (A = {})",
        decimal(impact.frequency()),
        decimal(impact.setup.amplitude)
    )));
    blocks
}

fn phases<'a>(impact: &Impact, phases: &'a ThreePhases) -> Vec<Block<'a>> {
    let setup = &impact.setup;
    let constant = phases.line.q(setup.barrier);
    let force = format!(
        "elastic force gamma*({}*x {} {}), fitted by {} over the depth {}",
        decimal(phases.line.slope),
        if constant < 0.0 { '+' } else { '-' },
        decimal(constant.abs()),
        setup.rule,
        decimal(phases.fitted_depth)
    );
    let mut blocks = vec![Block::Speed(phases.column), Block::Detail(force)];
    blocks.extend(phases.phases.iter().map(Block::Phase));
    if phases.velocity_jump != 0.0 {
        let jump = decimal(phases.velocity_jump);
        blocks.push(Block::Detail(format!("the velocity jumps by {jump} at either join")));
    }
    blocks
}

fn judged(impact: &Impact, tolerance: f64) -> Vec<Block<'_>> {
    const SPEEDS: [ContactSpeed; 2] = [ContactSpeed::Paper, ContactSpeed::Energy];
    let deviations = [&impact.paper_deviation, &impact.energy_deviation];
    // The power of ten above it; below 1e-15 nothing is known.
    let drift = 10_f64.powf(impact.truth.energy_drift.max(1e-15).log10().ceil());
    let mut blocks = vec![
        Block::Heading("Beside Runge-Kutta on the original equation".to_owned()),
        Block::Quantities {
            rows: impact.quantities().into(),
            deviations: deviations.map(|deviation| deviation.total / impact.setup.amplitude),
        },
        Block::Detail(format!(
            "Runge-Kutta keeps the energy to {drift:e} of the kinetic energy at touch"
        )),
        Block::Verdicts {
            verdicts: SPEEDS.map(|speed| impact.verdict(speed, tolerance)),
            tolerance,
        },
    ];
    for speed in SPEEDS {
        let shortcomings = impact.shortcomings(speed, tolerance).into_iter();
        blocks.extend(shortcomings.map(|(errors, cause)| Block::Shortcoming { speed, errors, cause }));
    }
    blocks
}

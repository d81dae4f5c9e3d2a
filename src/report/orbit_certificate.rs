//! Certificates of periodic impact orbits: what is proved of each.

use std::borrow::Cow;

use super::certificate::{enclosed, stability_of_driven};
use super::{Block, Document};
use crate::certificate::{
    CertifiedOrbit, ExactHarmonic, ExactWall, OrbitCertificate, OrbitNotProved, WalledOscillator,
    coordinate,
};
use crate::decimal::{decimal, rounded_down};
use crate::derivation::DerivationLine;
use crate::exact::Rational;
use crate::expr::{Expr, ExprError};
use crate::symbol::Symbol;

/// Proved orbits to be reported.
#[derive(Clone, Debug)]
pub struct OrbitCertificateReport<'a> {
    /// The certificate.
    pub certificate: &'a OrbitCertificate,
    /// Its orbits as they are proved.
    pub proved: Vec<&'a CertifiedOrbit>,
    /// Periods and speed of each orbit that is not proved, with the reason.
    pub not_proved: Vec<(u32, f64, &'a OrbitNotProved)>,
    /// The number of orbits of the closed form that no motion follows.
    pub not_followed: usize,
}

/// The document of proved orbits.
///
/// # Errors
/// A step of algebra that fails.
pub fn orbit_certificate<'a>(
    report: &OrbitCertificateReport<'a>,
) -> Result<Document<'a>, ExprError> {
    let mut sections = vec![question(&report.certificate.oscillator)?];
    let several = report.certificate.oscillator.walls.len() > 1;
    for (index, own) in report.proved.iter().enumerate() {
        sections.push(orbit(index + 1, own, several));
    }
    let mut others: Vec<Block> = report
        .not_proved
        .iter()
        .map(|(periods, speed, reason)| {
            let speed = decimal(*speed);
            Block::Sentence(format!(
                "not proved: the orbit of n = {periods} and the speed {speed}: {reason}"
            ))
        })
        .collect();
    match report.not_followed {
        0 => {}
        1 => others.push(Block::Sentence(
            "no motion follows another orbit of the closed form, which is beyond a wall between impacts".to_owned(),
        )),
        count => others.push(Block::Sentence(format!(
            "no motion follows {count} other orbits of the closed form, which are beyond a wall between impacts"
        ))),
    }
    if !others.is_empty() {
        sections.push(others);
    }
    sections.push(vec![
        Block::Heading("The proof".to_owned()),
        Block::Note("speed before: relative to the wall, just before the impact; phase: the frequency of the drive times the time of the impact".to_owned()),
        Block::Note("exactly one orbit with impacts on these walls in this order has its phases and speeds within the radii: interval Newton in the form of Krawczyk on the equations of the impacts".to_owned()),
        Block::Note("between impacts the gap of every wall is positive, on parts of each flight that cover it; multipliers from the enclosed monodromy matrix".to_owned()),
    ]);
    Ok(Document { sections })
}

/// The equation and the walls in numbers.
fn question<'a>(oscillator: &WalledOscillator) -> Result<Vec<Block<'a>>, ExprError> {
    let x = coordinate();
    let velocity = x.derivative();
    let term =
        |factor: &Rational, symbol: Symbol| &Expr::number(factor.clone()) * &Expr::from(symbol);
    let load = wave(&oscillator.load, &oscillator.frequency)?;
    let left = Expr::sum([
        Expr::from(velocity.derivative()),
        term(&oscillator.damping, velocity),
        term(&oscillator.stiffness, x),
        -&load,
    ]);
    let line = DerivationLine::equation(left, Expr::zero());
    let wall = |own: &ExactWall| {
        let place = wave(&own.place, &oscillator.frequency)?;
        let relation = if own.is_above { '<' } else { '>' };
        Ok::<_, ExprError>((
            "wall",
            format!("{x} {relation} {place} off it, restitution {}", own.restitution),
        ))
    };
    let walls: Result<Vec<_>, ExprError> = oscillator.walls.iter().map(wall).collect();
    Ok(vec![Block::Line(Cow::Owned(line)), Block::Facts(walls?)])
}

/// A constant and a wave as an expression in t.
fn wave(own: &ExactHarmonic, frequency: &Rational) -> Result<Expr, ExprError> {
    let phase = &Expr::number(frequency.clone()) * &Expr::from(Symbol::new("t"));
    let [constant, cosine, sine] =
        [&own.constant, &own.cosine, &own.sine].map(|factor| Expr::number(factor.clone()));
    Ok(Expr::sum([constant, &cosine * &phase.cos()?, &sine * &phase.sin()?]))
}

/// The enclosures of an orbit and its stability.
fn orbit<'a>(number: usize, own: &CertifiedOrbit, several: bool) -> Vec<Block<'a>> {
    let counted = |count: usize, what: &str| match count {
        1 => format!("one {what}"),
        count => format!("{count} {what}s"),
    };
    let heading = format!(
        "Proved, orbit {number}: {} in {} of the drive",
        counted(own.impacts.len(), "impact"),
        counted(own.periods as usize, "period"),
    );
    let mut facts: Vec<(&'static str, String)> = Vec::new();
    for impact in &own.impacts {
        let wall = match several {
            true => format!(", wall {}", impact.wall + 1),
            false => String::new(),
        };
        facts.push(("speed before", enclosed(&impact.speed) + &wall));
        facts.push(("phase", enclosed(&impact.phase)));
    }
    let [phase, speed] = own.isolation.map(|bound| rounded_down(bound.value().next_down(), 2));
    facts.push((
        "the only one",
        format!("within {phase} of these phases and {speed} of these speeds"),
    ));
    facts.push(("between impacts", "touches no wall".to_owned()));
    facts.push(("stability", stability_of_driven(Some(&own.multipliers))));
    vec![Block::Heading(heading), Block::Facts(facts)]
}

//! One-impact orbits in letters: speed, phase, multipliers, and the curves at which orbits begin,
//! merge or double their period. The equations are those of `one_impact` and `multipliers`.

use std::collections::BTreeMap;

use num_traits::Signed;

use super::equation::{BiasedHarmonic, ImpactEquation};
use super::error::OrbitError;
use super::orbit::OrbitKind;
use crate::expr::{Expr, ExprError, parse_expression};
use crate::solution::Definition;
use crate::symbol::{Symbol, fresh};

/// One-impact orbits on a wall, in letters.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitLaws {
    /// The orbits: one impact, or symmetric between two walls.
    pub kind: OrbitKind,
    /// The index of the wall.
    pub wall: usize,
    /// The gap: its letter and its meaning.
    pub gap: Definition,
    /// The equation of the gap between impacts: left and right side.
    pub equation: [Expr; 2],
    /// The symbols that shorten the formulas, each of those before it.
    pub definitions: Vec<Definition>,
    /// Speed, phase, trace, determinant and multipliers.
    pub relations: Vec<OrbitRelation>,
    /// The curves in the parameters at which the orbits change.
    pub curves: Vec<OrbitRelation>,
    /// Conventions, and where the formulas hold.
    pub validity: Vec<String>,
}

/// An equation of an orbit.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitRelation {
    /// The name: `speed`, `phase`, `trace`, `determinant`, `multipliers`; `grazing`, `fold`,
    /// `period-doubling`, `symmetry-breaking`.
    pub name: &'static str,
    /// The equation in words.
    pub words: &'static str,
    /// The left side.
    pub left: Expr,
    /// The right side.
    pub right: Expr,
}

/// The free motion between impacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FreeMotion {
    /// Oscillates, or has letters that leave it open.
    Underdamped,
    Critical,
    Overdamped,
    /// No stiffness.
    Ballistic,
}

/// Derives the orbits with one impact on a wall in n periods, or the symmetric ones.
///
/// # Errors
/// A step of algebra that fails.
pub(super) fn derive(
    question: &ImpactEquation,
    wall: usize,
    kind: OrbitKind,
) -> Result<OrbitLaws, OrbitError> {
    let free = free_motion(question, kind)?;
    let mut formulas = Formulas::new(question, wall);
    match free {
        FreeMotion::Ballistic => ballistic(&mut formulas)?,
        _ => restored(&mut formulas, free, kind)?,
    }
    let own = &question.walls[wall];
    let gap = formulas.taken_name("y");
    let acceleration = Expr::from(gap.derivative().derivative());
    let left = [
        acceleration,
        &question.damping * &Expr::from(gap.derivative()),
        &question.stiffness * &Expr::from(gap),
    ];
    Ok(OrbitLaws {
        kind,
        wall,
        gap: Definition { symbol: gap, meaning: own.wall.gap.clone() },
        equation: [Expr::sum(left), in_time(&own.load, &question.frequency)?],
        validity: validity(question, free, kind, &formulas),
        definitions: formulas.definitions,
        relations: formulas.relations,
        curves: formulas.curves,
    })
}

/// The kind of free motion; letters are taken to be underdamped.
fn free_motion(question: &ImpactEquation, kind: OrbitKind) -> Result<FreeMotion, ExprError> {
    if question.stiffness.is_zero() && kind != OrbitKind::Symmetric {
        return Ok(FreeMotion::Ballistic);
    }
    let square = Expr::product([question.damping.clone(), question.damping.clone()]);
    let square = (&question.stiffness - &Expr::divide(&square, &Expr::from(4))?).expand()?;
    Ok(match square.evaluate(&BTreeMap::new()) {
        Ok(square) if square < 0.0 => FreeMotion::Overdamped,
        Ok(0.0) => FreeMotion::Critical,
        _ => FreeMotion::Underdamped,
    })
}

fn in_time(load: &BiasedHarmonic<Expr>, frequency: &Expr) -> Result<Expr, ExprError> {
    let phase = frequency * &Expr::symbol("t");
    Ok(Expr::sum([load.constant.clone(), &load.cosine * &phase.cos()?, &load.sine * &phase.sin()?]))
}

/// Formulas that are written with the letters of the head of `one_impact` and put into those of
/// the question.
struct Formulas {
    /// The expression for each letter of the texts.
    letters: BTreeMap<Symbol, Expr>,
    /// The names of the question, and those given so far.
    taken: Vec<Symbol>,
    names: BTreeMap<&'static str, Symbol>,
    definitions: Vec<Definition>,
    relations: Vec<OrbitRelation>,
    curves: Vec<OrbitRelation>,
}

impl Formulas {
    fn new(question: &ImpactEquation, wall: usize) -> Self {
        let mut taken = question.oscillator.names();
        taken.extend(question.parameters());
        let own = &question.walls[wall];
        let given = [
            ("c", &question.damping),
            ("k", &question.stiffness),
            ("omega", &question.frequency),
            ("e", &own.wall.restitution),
            ("P", &own.load.constant),
            ("A", &own.load.cosine),
            ("B", &own.load.sine),
            ("place", &own.offset.constant),
        ];
        let letters = given.map(|(name, value)| (Symbol::new(name), value.clone()));
        Self {
            letters: letters.into(),
            taken,
            names: BTreeMap::new(),
            definitions: vec![],
            relations: vec![],
            curves: vec![],
        }
    }

    /// A name for an unknown, from now on what the texts mean by it.
    fn taken_name(&mut self, name: &'static str) -> Symbol {
        if let Some(known) = self.names.get(name) {
            return *known;
        }
        let symbol = fresh(name, &self.taken);
        self.taken.push(symbol);
        self.names.insert(name, symbol);
        self.letters.insert(Symbol::new(name), Expr::from(symbol));
        symbol
    }

    fn formula(&self, text: &str) -> Result<Expr, OrbitError> {
        // The texts are of this file, and in the grammar.
        let parsed = parse_expression(text).map_err(crate::wall::WallError::Parse)?;
        Ok(parsed.substitute_all(&self.letters)?)
    }

    /// Gives a name to a formula; a single symbol or number needs none.
    fn define(&mut self, name: &'static str, text: &str) -> Result<(), OrbitError> {
        let meaning = self.formula(text)?;
        if meaning.as_symbol().is_some() || meaning.as_number().is_some() {
            self.letters.insert(Symbol::new(name), meaning);
            return Ok(());
        }
        let symbol = self.taken_name(name);
        self.definitions.push(Definition { symbol, meaning });
        Ok(())
    }

    fn relation(
        &self,
        [name, words]: [&'static str; 2],
        [left, right]: [&str; 2],
    ) -> Result<OrbitRelation, OrbitError> {
        Ok(OrbitRelation { name, words, left: self.formula(left)?, right: self.formula(right)? })
    }

    fn relate(&mut self, of: [&'static str; 2], sides: [&str; 2]) -> Result<(), OrbitError> {
        let relation = self.relation(of, sides)?;
        self.relations.push(relation);
        Ok(())
    }

    fn curve(&mut self, of: [&'static str; 2], sides: [&str; 2]) -> Result<(), OrbitError> {
        let relation = self.relation(of, sides)?;
        self.curves.push(relation);
        Ok(())
    }

    fn is_zero(&self, name: &str) -> bool {
        self.letters.get(&Symbol::new(name)).is_some_and(Expr::is_zero)
    }

    /// U, V and X, the steady wave of the gap and its amplitude.
    fn steady_wave(&mut self) -> Result<(), OrbitError> {
        const SQUARE: &str = "((k - omega^2)^2 + c^2*omega^2)";
        self.define("U", &format!("(A*(k - omega^2) - c*omega*B)/{SQUARE}"))?;
        self.define("V", &format!("(B*(k - omega^2) + c*omega*A)/{SQUARE}"))?;
        // A single wave has its own letter as amplitude, without its sign.
        let sign = |name: &str| {
            self.letters.get(&Symbol::new(name)).is_some_and(|own| own.has_leading_minus())
        };
        let size = match (self.is_zero("A"), self.is_zero("B")) {
            (false, true) if sign("A") => "(-A)",
            (false, true) => "A",
            (true, false) if sign("B") => "(-B)",
            (true, false) => "B",
            _ => {
                let square = self.formula("A^2 + B^2")?.expand()?.factored();
                self.letters.insert(Symbol::new("size"), square.sqrt()?);
                "size"
            }
        };
        // Without damping or stiffness the root is a sum whose sign the letters leave open.
        let below = match self.is_zero("k") {
            true => "(omega*sqrt(omega^2 + c^2))".to_owned(),
            false if self.is_zero("c") => "abs(k - omega^2)".to_owned(),
            false => format!("sqrt{SQUARE}"),
        };
        match self.is_zero("k") && self.is_zero("c") {
            true => self.define("X", &format!("{size}/omega^2")),
            false => self.define("X", &format!("{size}/{below}")),
        }
    }

    fn multipliers(&mut self) -> Result<(), OrbitError> {
        self.taken_name("lambda");
        self.relate(
            ["multipliers", "multipliers, with either sign of the root"],
            ["lambda", "tr/2 + sqrt(tr^2/4 - det)"],
        )
    }
}

/// The formulas with a stiffness.
fn restored(formulas: &mut Formulas, free: FreeMotion, kind: OrbitKind) -> Result<(), OrbitError> {
    let is_symmetric = kind == OrbitKind::Symmetric;
    let mirror = if is_symmetric { "-" } else { "" };
    formulas.taken_name("n");
    formulas.define("Q", if formulas.is_zero("k") { "place" } else { "P/k" })?;
    let mean = formulas.formula("Q")?.expand()?;
    if let Some(last) = formulas.definitions.last_mut() {
        last.meaning = last.meaning.expand()?;
        // A wall at d about a mean of zero has the gap d.
        if last.meaning.as_symbol().is_some() || last.meaning.as_number().is_some() {
            formulas.letters.insert(Symbol::new("Q"), last.meaning.clone());
            formulas.definitions.pop();
        }
    } else {
        formulas.letters.insert(Symbol::new("Q"), mean);
    }
    formulas.steady_wave()?;
    formulas.define("T", if is_symmetric { "pi*n/omega" } else { "2*pi*n/omega" })?;
    formulas.define("beta", "c/2")?;
    formulas.define("E", "exp(-beta*T)")?;
    match free {
        FreeMotion::Overdamped => {
            formulas.define("omega_d", "sqrt(beta^2 - k)")?;
            formulas.define("C", &format!("{mirror}E*cosh(omega_d*T)"))?;
            formulas.define("S", &format!("{mirror}E*sinh(omega_d*T)/omega_d"))?;
        }
        FreeMotion::Critical => {
            formulas.define("C", &format!("{mirror}E"))?;
            formulas.define("S", &format!("{mirror}E*T"))?;
        }
        _ => {
            formulas.define("omega_d", "sqrt(k - beta^2)")?;
            formulas.define("C", &format!("{mirror}E*cos(omega_d*T)"))?;
            formulas.define("S", &format!("{mirror}E*sin(omega_d*T)/omega_d"))?;
        }
    }
    formulas.define("D", "1 - 2*C + E^2")?;
    formulas.define("a", "(1 + e)*S/D")?;
    formulas.define("b", "e - (1 + e)*(1 - C - beta*S)/D")?;
    formulas.taken_name("v");
    formulas.relate(["speed", "the impact speed"], ["(Q + a*v)^2 + (b*v/omega)^2", "X^2"])?;
    formulas.relate(
        ["speed", "solved, with either sign of the root"],
        ["v", "(-a*Q + sqrt((a^2 + b^2/omega^2)*X^2 - (b*Q/omega)^2))/(a^2 + b^2/omega^2)"],
    )?;
    formulas.taken_name("phi");
    formulas.relate(["phase", "the phase"], ["U*cos(phi) + V*sin(phi)", "-(Q + a*v)"])?;
    formulas.relate(["phase", "and"], ["V*cos(phi) - U*sin(phi)", "b*v/omega"])?;
    formulas.taken_name("tr");
    formulas.taken_name("det");
    formulas.relate(
        ["trace", "trace"],
        ["tr", "-2*e*C - (1 + e)*S*(omega^2*Q/v + a*(omega^2 - k) + b*c)"],
    )?;
    formulas.relate(["determinant", "determinant"], ["det", "e^2*E^2"])?;
    formulas.multipliers()?;
    // A wall at or beyond the place of rest leaves no motion without impacts.
    let gap_at_rest = formulas.formula("Q")?;
    if gap_at_rest.as_number().is_none_or(Signed::is_positive) {
        formulas.curve(["grazing", "grazing of the motion without impacts"], ["X", "Q"])?;
    }
    formulas.curve(
        ["fold", "fold, where both speeds are one"],
        ["X^2", "(b*Q/omega)^2/(a^2 + b^2/omega^2)"],
    )?;
    let doubling = match is_symmetric {
        true => ["symmetry-breaking", "symmetry breaking, 1 + tr + det = 0"],
        false => ["period-doubling", "period doubling, 1 + tr + det = 0"],
    };
    formulas.curve(
        doubling,
        ["v", "(1 + e)*S*omega^2*Q/(1 - 2*e*C + e^2*E^2 - (1 + e)*S*(a*(omega^2 - k) + b*c))"],
    )?;
    formulas.curve([doubling[0], "with this speed"], ["X^2", "(Q + a*v)^2 + (b*v/omega)^2"])
}

/// The formulas without stiffness.
fn ballistic(formulas: &mut Formulas) -> Result<(), OrbitError> {
    formulas.taken_name("n");
    formulas.steady_wave()?;
    formulas.define("T", "2*pi*n/omega")?;
    let is_undamped = formulas.is_zero("c");
    match is_undamped {
        true => {
            formulas.letters.insert("E".into(), Expr::one());
            let length = formulas.formula("T")?;
            formulas.letters.insert("S".into(), length);
            let half = formulas.formula("T/2")?;
            formulas.letters.insert("r".into(), half);
        }
        false => {
            formulas.define("E", "exp(-c*T/2)")?;
            formulas.define("S", "(1 - E^2)/c")?;
            formulas.define("r", "(T/S - 1)/c")?;
        }
    }
    formulas.taken_name("v");
    formulas.relate(["speed", "the impact speed, by momentum"], ["v", "-P*T/(1 + e)"])?;
    formulas.taken_name("u");
    formulas.relate(["wave-velocity", "velocity of the wave at the impact"], ["u", "e*v + P*r"])?;
    formulas.taken_name("q");
    formulas.relate(
        ["wave-position", "its position, with either sign of the root"],
        ["q", "sqrt(X^2 - u^2/omega^2)"],
    )?;
    formulas.taken_name("phi");
    formulas.relate(["phase", "the phase"], ["U*cos(phi) + V*sin(phi)", "q"])?;
    formulas.relate(["phase", "and"], ["V*cos(phi) - U*sin(phi)", "u/omega"])?;
    formulas.taken_name("tr");
    formulas.taken_name("det");
    formulas
        .relate(["trace", "trace"], ["tr", "-e*(1 + E^2) - (1 + e)*S*(P - omega^2*q + c*u)/v"])?;
    formulas.relate(["determinant", "determinant"], ["det", "e^2*E^2"])?;
    formulas.multipliers()?;
    formulas.curve(["fold", "fold, where both phases are one"], ["X^2", "u^2/omega^2"])?;
    formulas.curve(
        ["period-doubling", "period doubling, 1 + tr + det = 0"],
        ["q", "(P + c*u - v*(1 - e*(1 + E^2) + e^2*E^2)/((1 + e)*S))/omega^2"],
    )?;
    formulas.curve(["period-doubling", "with this position"], ["X^2", "q^2 + u^2/omega^2"])
}

/// Conventions, and where the formulas hold.
fn validity(
    question: &ImpactEquation,
    free: FreeMotion,
    kind: OrbitKind,
    formulas: &Formulas,
) -> Vec<String> {
    let name =
        |own: &'static str| formulas.names.get(own).map_or(own.to_owned(), ToString::to_string);
    let (v, phi, y, n) = (name("v"), name("phi"), name("y"), name("n"));
    let e = &question.walls[0].wall.restitution;
    let omega = &question.frequency;
    let mut notes = vec![
        format!(
            "{v} is the speed relative to the wall just before the impact, {v} times {e} that just after it; {phi} = {omega}*t is the phase of the drive there"
        ),
        match kind {
            OrbitKind::Symmetric => format!(
                "one impact on each wall in {n} periods of the drive, {n} odd, the second half the mirror image of the first; the multipliers are those of half an orbit with its mirror image: over the whole orbit they are squared"
            ),
            _ => format!("one impact in {n} periods of the drive, {n} = 1, 2, 3, ..."),
        },
        format!(
            "a motion follows the orbit only if {v} > 0 and the gap {y} stays positive between the impacts, which no closed formula decides: with --at it is checked"
        ),
        "stable where |tr| < 1 + det; tr = 1 + det is the fold".to_owned(),
    ];
    let decided =
        question.damping.as_number().is_some() && question.stiffness.as_number().is_some();
    if free == FreeMotion::Underdamped && !decided {
        let (rate, time, decay) = (name("omega_d"), name("T"), name("E"));
        notes.push(match question.damping.is_zero() {
            true => format!("for a positive stiffness `{}`", question.stiffness),
            false => format!(
                "written for an underdamped motion; where {rate} is imaginary put cosh and sinh with |{rate}| in place of cos and sin, where it is 0 put sin({rate}*{time})/{rate} = {time} ({decay} as it is); --at chooses by itself"
            ),
        });
    }
    if free != FreeMotion::Ballistic && question.damping.is_zero() {
        notes.push(format!(
            "not where {} = 0: there the free motion returns to itself and cannot make up for the impact",
            name("D")
        ));
    }
    if free == FreeMotion::Ballistic {
        notes.push("the constant force pushes towards the wall".to_owned());
    }
    notes
}

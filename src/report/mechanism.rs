//! A mechanism: its energies, its equations of motion, its equilibria, its modes there, and its
//! dimensionless groups.

use std::borrow::Cow;

use super::{Block, Document};
use crate::audit::paper::Finding;
use crate::decimal::decimal;
use crate::derivation::DerivationLine;
use crate::expr::{Expr, Function};
use crate::mechanics::{
    DriveAtRest, Groups, MechanicsError, MechanismStudy, Mode, RestPosition, RestStudy,
};
use crate::symbol::Symbol;

/// The document of a study of a mechanism.
///
/// ```
/// use lindstedt::{audit::paper, mechanics::study};
///
/// let study = study(paper::mechanism())?;
/// let document = lindstedt::report::mechanism(&study);
/// assert!(lindstedt::export::text::document(&document, 120).contains("stiffness of the contact"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn mechanism(study: &MechanismStudy) -> Document<'_> {
    let mut sections = vec![energies(study), equations(study), places(study)];
    sections.push(match &study.groups {
        None => vec![Block::Note(
            "without [units] no term is checked, and there are no dimensionless groups".to_owned(),
        )],
        Some(Err(error)) => vec![checked(), Block::Note(no_groups(error))],
        Some(Ok(groups)) => dimensionless(groups, study),
    });
    Document { sections }
}

fn equation<'a>(left: Expr, right: Expr) -> Block<'a> {
    Block::Line(Cow::Owned(DerivationLine::equation(left, right)))
}

fn energies(study: &MechanismStudy) -> Vec<Block<'_>> {
    let mechanism = &study.question.mechanism;
    let mut blocks = vec![Block::Heading("Energies and forces".to_owned())];
    let named =
        [("T", &mechanism.kinetic), ("V", &mechanism.potential), ("D", &mechanism.dissipation)];
    for (name, energy) in
        named.into_iter().filter(|(name, energy)| *name != "D" || !energy.is_zero())
    {
        blocks.push(equation(Expr::symbol(name), energy.clone()));
    }
    for (on, force) in &mechanism.forces {
        blocks.push(equation(Expr::symbol(&format!("Q_{on}")), force.clone()));
    }
    blocks
}

fn equations(study: &MechanismStudy) -> Vec<Block<'_>> {
    let equations = &study.equations;
    let several = if equations.left.len() > 1 { "s" } else { "" };
    let mut blocks = vec![Block::Heading(format!("Equation{several} of motion, by Lagrange"))];
    for left in &equations.left {
        blocks.push(equation(left.clone(), Expr::zero()));
    }
    let divided: Vec<String> = equations
        .divisors
        .iter()
        .filter(|divisor| !divisor.is_one())
        .map(ToString::to_string)
        .collect();
    if !divided.is_empty() {
        blocks.push(Block::Note(format!("divided by {}", divided.join(" and "))));
    }
    blocks
}

fn places(study: &MechanismStudy) -> Vec<Block<'_>> {
    let coordinates = &study.equations.coordinates;
    let mut blocks = vec![Block::Heading(match study.rests.is_empty() {
        true => "No place of rest was found".to_owned(),
        false => "Places of rest, and small swings about them; others are not ruled out".to_owned(),
    })];
    let has = |function: Function| {
        study.equations.rest.iter().any(|rest| rest.contains_function(function))
    };
    let driven = study.equations.rest.iter().any(|rest| rest.contains(Symbol::new("t")));
    let vanishes = !study.rests.is_empty()
        && study.rests.iter().all(|rest| rest.drive == DriveAtRest::Vanishes);
    let changes = study.rests.iter().any(|rest| rest.modes.changing.is_some());
    if vanishes && changes && !has(Function::Step) {
        blocks.push(Block::Note("at rest there with the terms in t, too".to_owned()));
    } else if vanishes && !has(Function::Step) {
        blocks.push(Block::Note(
            "at rest there with the terms in t, too; the swings are those without them, which may hold what falls and shake loose what rests"
                .to_owned(),
        ));
    } else if driven || has(Function::Step) {
        blocks.push(Block::Note(
            "of the equations without the terms in t and without contacts, H(..): where those act there is no such rest".to_owned(),
        ));
    }
    let is_whole = !driven && !has(Function::Step) && !has(Function::Sign);
    for rest in &study.rests {
        blocks.push(Block::Note(rest_in_words(rest, coordinates)));
        let anywhere = rest.rest.places.contains(&RestPosition::Anywhere);
        let unpulled = match (anywhere, is_whole) {
            (true, true) => "moves freely",
            (true, false) => "moves freely where nothing that is left out acts",
            (false, _) => "no linear force pulls it back: what does is of a higher power",
        };
        if let Ok(Some(square)) = rest.modes.square() {
            let why = match square.is_zero() && rest.numbers.is_none() {
                true => format!(": {unpulled}"),
                false => String::new(),
            };
            blocks.push(Block::Note(format!("  omega^2 = {square}{why}")));
        }
        match &rest.numbers {
            Some(Ok(modes)) => blocks.extend(modes.iter().map(|mode| {
                Block::Note(format!("  {}", mode_in_words(mode, coordinates, unpulled)))
            })),
            Some(Err(error)) => blocks.push(Block::Note(format!("  {error}"))),
            None => blocks.extend(rest.modes.changing.clone().map(|changing| {
                let why = MechanicsError::Changing(changing);
                Block::Note(format!("  {why}"))
            })),
        }
    }
    let missing: std::collections::BTreeSet<Symbol> = study
        .rests
        .iter()
        .flat_map(|rest| rest.modes.parameters())
        .filter(|name| !study.question.values.contains_key(name))
        .collect();
    let missing: Vec<&str> = missing.iter().map(|name| name.name()).collect();
    if !study.question.values.is_empty() {
        let values = study.question.values.iter();
        let values: Vec<String> =
            values.map(|(name, value)| format!("{name} = {}", decimal(*value))).collect();
        let wanting = match missing.is_empty() {
            true => String::new(),
            false => format!("; numbers need a value for {} too", missing.join(", ")),
        };
        blocks.push(Block::Note(format!("at {}{wanting}", values.join(", "))));
    }
    let has_numbers = study.rests.iter().any(|rest| rest.numbers.is_some()) || changes;
    if coordinates.len() > 1
        && !study.rests.is_empty()
        && !has_numbers
        && study.question.values.is_empty()
    {
        blocks.push(Block::Note(
            "with values for every parameter come the frequencies and shapes of the modes"
                .to_owned(),
        ));
    }
    blocks
}

fn rest_in_words(rest: &RestStudy, coordinates: &[Symbol]) -> String {
    let place = |(name, place): (&Symbol, &RestPosition)| match place {
        RestPosition::At(value) => format!("{name} = {value}"),
        RestPosition::Anywhere => format!("any {name}"),
    };
    let places: Vec<String> = coordinates.iter().zip(&rest.rest.places).map(place).collect();
    let condition = rest.rest.condition.as_ref();
    let condition = condition.map_or(String::new(), |cosine| format!(", where |{cosine}| < 1"));
    let zero: Vec<String> =
        rest.modes.taken_at_zero.iter().map(|name| format!("{name} = 0")).collect();
    let zero = match zero.is_empty() {
        true => String::new(),
        false => format!("; the modes, which depend on it, at {}", zero.join(", ")),
    };
    format!("{}{condition}{zero}", places.join(", "))
}

/// A mode in words; `unpulled` is the text for one that neither oscillates nor grows.
fn mode_in_words(mode: &Mode, coordinates: &[Symbol], unpulled: &str) -> String {
    let shape = mode.shape.as_ref().filter(|shape| shape.len() > 1).map(|shape| {
        let parts: Vec<String> = coordinates.iter().map(|name| name.name().to_owned()).collect();
        let numbers: Vec<String> = shape.iter().map(|part| decimal(*part)).collect();
        format!(", {} = {}", parts.join(" : "), numbers.join(" : "))
    });
    let shape = shape.unwrap_or_default();
    match (mode.frequency > 0.0, mode.growth) {
        (true, 0.0) => format!("swings with omega = {}{shape}", decimal(mode.frequency)),
        (true, growth) => format!(
            "swings with omega = {} and {} like exp({} t){shape}",
            decimal(mode.frequency),
            if growth > 0.0 { "grows" } else { "decays" },
            decimal(growth)
        ),
        (false, 0.0) => format!("{unpulled}{shape}"),
        (false, growth) if growth > 0.0 => {
            format!("unstable: leaves like exp({} t){shape}", decimal(growth))
        }
        (false, growth) => format!("creeps back like exp({} t){shape}", decimal(growth)),
    }
}

fn checked<'a>() -> Block<'a> {
    Block::Heading(
        "Every term has the unit of its place: energies J, dissipation W, forces J over their coordinate".to_owned(),
    )
}

fn no_groups(error: &MechanicsError) -> String {
    format!("no dimensionless groups: {error}")
}

fn dimensionless<'a>(groups: &'a Groups, study: &'a MechanismStudy) -> Vec<Block<'a>> {
    let coordinates = &study.equations.coordinates;
    let names: Vec<&str> = groups.units.iter().map(|name| name.name()).collect();
    let most = groups.parameters + groups.sizes.len() - groups.rank;
    let found = groups.groups.len();
    let mut blocks = vec![
        checked(),
        Block::Sentence(format!(
            "{} parameters{} of {} independent dimension{}: {}. Units: {}.",
            groups.parameters,
            match groups.sizes.len() {
                0 => "",
                1 => " and the size of the motion,",
                _ => " and the sizes of the motion,",
            },
            groups.rank,
            if groups.rank == 1 { "" } else { "s" },
            match (most, found) {
                (0, _) => "no number is left, all such motions are one".to_owned(),
                (1, _) => "the motion depends on one number".to_owned(),
                (most, found) if most == found => format!("the motion depends on {found} numbers"),
                (most, found) =>
                    format!("at most {most} numbers are left, and the motion depends on {found}"),
            },
            names.join(", ")
        )),
    ];
    for combination in &groups.combinations {
        let line = DerivationLine::equation(combination.name, combination.meaning.clone());
        blocks.push(Block::Line(Cow::Owned(line.because("counts as one parameter"))));
    }
    if let Ok(square) =
        Expr::divide(&Expr::one(), &groups.time).and_then(|rate| rate.integer_power(2))
    {
        let name = match study.question.mechanism.parameters().contains(&Symbol::new("omega")) {
            true => String::new(),
            false => format!(", 1/omega with omega^2 = {square}"),
        };
        blocks.push(Block::Note(format!("time in units of {}{name}", groups.time)));
    }
    for (coordinate, length) in
        coordinates.iter().zip(&groups.lengths).filter(|(_, length)| !length.is_one())
    {
        blocks.push(Block::Note(format!("{coordinate} in units of {length}")));
    }
    for (coordinate, size) in &groups.sizes {
        let depends = match groups.time.contains(*size) {
            true => "its time grows and shrinks with that",
            false => "the equations are the same for each",
        };
        blocks.push(Block::Note(format!(
            "no product of the parameters has the unit of {coordinate}: {size} is any size of it, such as that at the start, and {depends}"
        )));
    }
    for group in &groups.groups {
        let line = match group.definition.as_symbol() == Some(group.name) {
            true => DerivationLine::words(format!("{}, a number as it is given", group.name)),
            false => DerivationLine::equation(group.name, group.definition.clone())
                .because(group.meaning.clone()),
        };
        blocks.push(Block::Line(Cow::Owned(line)));
    }
    for left in &groups.left {
        blocks.push(equation(left.clone(), Expr::zero()));
    }
    blocks
}

/// The section of the paper's equations, each compared with that of the paper's mechanism.
///
/// ```
/// use lindstedt::{audit::paper, mechanics::study};
///
/// let study = study(paper::mechanism())?;
/// let mut document = lindstedt::report::mechanism(&study);
/// let findings = paper::findings()?;
/// document.sections.push(lindstedt::report::paper_equations(&findings));
/// assert!(lindstedt::export::text::document(&document, 120).contains("with the square"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn paper_equations(findings: &[Finding]) -> Vec<Block<'_>> {
    let entry = |finding: &Finding| {
        let verdict = match finding.agrees {
            Some(true) => "follows",
            Some(false) => "does not follow as printed",
            None => "is put in",
        };
        (finding.equation.clone(), format!("{verdict}: {}", finding.words))
    };
    let printed = findings
        .iter()
        .map(|finding| Block::Detail(format!("{} {}", finding.equation, finding.printed)));
    let mut blocks = vec![Block::Heading("The paper's equations, in these letters".to_owned())];
    blocks.extend(printed);
    blocks.push(Block::Entries {
        heading: "What becomes of them",
        entries: findings.iter().map(entry).collect(),
    });
    blocks
}

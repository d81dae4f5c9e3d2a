//! The program of nonlinear normal modes in any language: of each mode the frequency, and of each
//! coordinate the displacement and the velocity.

use std::collections::{BTreeMap, BTreeSet};

use num_traits::Zero as _;

use super::program::{
    FREQUENCY, FunctionPrologue, Harmonic, ProgramNames, SEVERAL_EQUATIONS, angle,
    displacement_and_velocity, in_order, lines_of, resolved, root_of_square, share_arguments,
    variables,
};
use super::{NoCode, Program, Routine, Statement, Value};
use crate::exact::rational::from_f64;
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::Expr;
use crate::modes::NonlinearMode;
use crate::report::{Block, Document, ModesReport};
use crate::series::FourierSeries;
use crate::symbol::{Symbol, fresh};
use crate::verify::JudgedMode;

/// The program of all modes that have a formula.
///
/// # Errors
/// [`NoCode`] for a balance of harmonics without values.
pub(super) fn program(report: &ModesReport) -> Result<Program, NoCode> {
    let mut routines = Vec::new();
    for (mode, judged) in report.judged_modes() {
        let own = match mode.balance {
            Some(_) => one_mode(report, &in_numbers(mode, judged)?),
            None => one_mode(report, mode),
        };
        let program = Program { header: vec![], routines: own };
        routines.extend(program.with_prefix(&format!("mode{}_", mode.number)).routines);
    }
    Ok(Program { routines, header: header(report) })
}

/// A mode by balance of harmonics with the numbers that were found at the values.
fn in_numbers(
    mode: &NonlinearMode,
    judged: Option<&Result<JudgedMode, String>>,
) -> Result<NonlinearMode, NoCode> {
    let judged = match judged {
        None => return Err(NoCode::SolvedByNumbers(SEVERAL_EQUATIONS.to_owned())),
        Some(Err(reason)) => return Err(NoCode::NoMotion(Some(reason.clone()))),
        Some(Ok(judged)) => judged,
    };
    let number = |value: f64| from_f64(value).map(Polynomial::constant).ok_or(NoCode::Beyond);
    let frequency = judged.frequency.ok_or(NoCode::NoMotion(None))?;
    let mut known = BTreeMap::new();
    for (name, value) in &judged.coefficients {
        known.insert(*name, number(*value)?);
    }
    let of = |coefficient: &Polynomial| {
        let name = coefficient.symbols().into_iter().next();
        name.and_then(|name| known.get(&name).cloned()).unwrap_or_else(Polynomial::zero)
    };
    let in_numbers = |series: &FourierSeries<Polynomials>| {
        series.map(POLYNOMIALS, |coefficient, _| of(coefficient))
    };
    Ok(NonlinearMode {
        frequency_squared: number(frequency * frequency)?,
        motion: mode.motion.iter().map(in_numbers).collect(),
        rounded: true,
        ..mode.clone()
    })
}

/// The report without its formulas.
fn header(report: &ModesReport) -> Vec<String> {
    let mut document: Document = crate::report::modes(report);
    let is_formula = |block: &Block| {
        matches!(
            block,
            Block::Law { .. }
                | Block::Equality { .. }
                | Block::Harmonics { .. }
                | Block::Definition(_)
                | Block::Detail(_)
        )
    };
    for section in &mut document.sections {
        section.retain(|block| !is_formula(block));
    }
    document.sections.retain(|section| !section.is_empty());
    lines_of(&document)
}

/// The functions of a mode.
fn one_mode(report: &ModesReport, mode: &NonlinearMode) -> Vec<Routine> {
    let system = &report.modes.system;
    let coordinates = &system.equations.coordinates;
    let defined = mode.definitions.iter().map(|definition| definition.symbol);
    let taken: Vec<Symbol> = system.names().into_iter().chain(defined).collect();
    let names = ProgramNames::new(mode.amplitude.symbol(), report.phase(), &taken);
    let in_terms = |polynomial: &Polynomial| in_order(&mode.ordered(polynomial));
    let (parts, law, symbols) = match &mode.approximant {
        Some(own) => {
            let [p, q] = ["p", "q"].map(|letter| fresh(letter, &taken));
            let quotient = Expr::divide(&Expr::from(p), &Expr::from(q));
            let value = Value::Expression(quotient.unwrap_or_else(|_| own.value.clone()));
            let parts = [(p, &own.above), (q, &own.below)]
                .map(|(name, part)| Statement::Variable(name, in_terms(part)));
            (parts.into(), value, &own.above.symbols() | &own.below.symbols())
        }
        None => (vec![], in_terms(&mode.frequency_squared), mode.frequency_squared.symbols()),
    };
    let (definitions, of_frequency) = resolved(&mode.definitions, &names, symbols);
    let before = variables(definitions).chain(parts).collect();
    let mut routines = vec![root_of_square(&names, of_frequency.clone(), before, law, vec![])];
    for (index, name) in coordinates.iter().enumerate() {
        let mut motion = motion(mode, index, &names, &of_frequency);
        let rest = &system.rest[index];
        let from = match rest.is_zero() {
            true => String::new(),
            false => format!(", counted from its place of rest, {rest}"),
        };
        for (routine, about) in motion.iter_mut().zip(["displacement", "velocity"]) {
            routine.about = format!("The {about} of {name} at the time t{from}");
            routine.name = format!("{}_{}", routine.name, as_word(*name));
        }
        routines.extend(motion);
    }
    share_arguments(&names, &mut routines);
    routines
}

/// The name of a coordinate as a part of that of a function.
fn as_word(name: Symbol) -> String {
    name.written().replace(|letter: char| !letter.is_ascii_alphanumeric(), "_")
}

/// Displacement and velocity of a coordinate.
fn motion(
    mode: &NonlinearMode,
    index: usize,
    names: &ProgramNames,
    of_frequency: &[Symbol],
) -> [Routine; 2] {
    let harmonics: Vec<(usize, Polynomial)> = mode.motion[index]
        .harmonics()
        .into_iter()
        .map(|(k, cosine, _)| (k, cosine))
        .filter(|(_, cosine)| !cosine.is_zero())
        .collect();
    let beginning = |least: usize| {
        let own = harmonics.iter().filter(|(k, _)| *k >= least);
        // A constant needs neither frequency nor time.
        if own.clone().all(|(k, _)| *k == 0) {
            let symbols: BTreeSet<Symbol> = own.flat_map(|(_, cosine)| cosine.symbols()).collect();
            let (definitions, mut arguments) = resolved(&mode.definitions, names, symbols);
            arguments.insert(0, names.time);
            let unused = Statement::Unused(names.time);
            let body = std::iter::once(unused).chain(variables(definitions)).collect();
            return FunctionPrologue { arguments, body };
        }
        let symbols: BTreeSet<Symbol> =
            own.flat_map(|(_, cosine)| cosine.symbols()).chain(of_frequency.to_vec()).collect();
        let (definitions, mut arguments) = resolved(&mode.definitions, names, symbols);
        arguments.insert(0, names.time);
        let frequency = Value::Call(FREQUENCY.to_owned(), of_frequency.to_vec());
        let own = [Statement::Variable(names.omega, frequency), angle(names)];
        FunctionPrologue { arguments, body: variables(definitions).chain(own).collect() }
    };
    let coefficient = |polynomial: &Polynomial| Some(in_order(&mode.ordered(polynomial)));
    let displaced = harmonics.iter().map(|(k, cosine)| Harmonic {
        k: *k,
        cosine: coefficient(cosine),
        sine: None,
    });
    let moving = harmonics.iter().filter(|(k, _)| *k > 0).map(|(k, cosine)| {
        let factor = Rational::from_integer((*k).into());
        let slope: Polynomial = cosine.map(|number| -(number * &factor));
        Harmonic { k: *k, cosine: None, sine: coefficient(&slope) }
    });
    displacement_and_velocity(
        names,
        [beginning(0), beginning(1)],
        None,
        displaced.collect(),
        moving.collect(),
    )
}

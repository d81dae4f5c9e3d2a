//! `lindstedt shortest PROBLEM --range A=0:2.8 --error 0.001`.

use std::path::Path;

use crate::catalog;
use crate::certificate::{LawQuantity, restitution};
use crate::coupled::CoupledEquations;
use crate::exact::Rational;
use crate::export::{code, json, shortest as drawing};
use crate::expr::Expr;
use crate::modes::{ModeError, ModeOptions, derive};
use crate::problem::{Problem, ReadingCommand};
use crate::report::{self, ShortestReport};
use crate::shortest::{
    Atom, Front, LawMotion, LawProblem, PublishedFormula, SearchOptions, ShortestError, search,
};
use crate::solution::AmplitudeConvention;
use crate::symbol::{Symbol, fresh};
use crate::values::Values;
use clap::Args;

use super::answer::{Answer, Draw, no_such};
use super::derive::{as_meant, convention, exact_values, formula, oscillator};
use super::files::width;
use super::modes::{free_system, refused};
use super::problem::{coupled_equations, expression, problem};
use super::progress::with_progress;
use super::walls::ContactArguments;
use super::{Common, Failure, Format, Outcome, Work, json_text, session};

/// The shortest frequency law within an error on a whole range, with a proof of the bound, and the
/// front of length against error
#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
pub struct ShortestArguments {
    /// An equation in quotes, a TOML file, a name of the catalogue, or - for standard input
    problem: String,
    #[command(flatten)]
    contacts: ContactArguments,
    /// What varies, and from where to where: the amplitude (A=0:2.8), a parameter (mu=0:10), or a
    /// product on which the frequency alone depends (eps*A^2=0:inf)
    #[arg(long, value_name = "NAME=FROM:TO", allow_hyphen_values = true)]
    range: String,
    /// The largest relative error that is allowed, 0.001 say; without it the whole front
    #[arg(long, value_name = "R", value_parser = super::positive, allow_hyphen_values = true)]
    error: Option<f64>,
    /// The law's quantity: omega, omega^2, T, the period over 2 pi, or contact-time, the duration of a
    /// contact x'' + k*x^n*(1 + c*x') = 0 over that without damping
    #[arg(long, value_parser = ["omega", "omega^2", "T", "contact-time"], default_value = "omega")]
    quantity: String,
    /// The equilibrium to swing about, x=1 say, from which the amplitude is measured
    #[arg(long, value_name = "NAME=VALUE,...")]
    about: Option<String>,
    /// The normal mode of coupled equations, 1 for the slowest
    #[arg(long, value_name = "N", value_parser = super::count, allow_hyphen_values = true)]
    mode: Option<u32>,
    /// The measure of a mode's amplitude
    #[arg(long, value_parser = convention())]
    amplitude: Option<AmplitudeConvention>,
    /// The value of another parameter, exact (1.5, 3/2); of the amplitude where a parameter varies
    /// (repeatable)
    #[arg(long, value_name = "NAME=VALUE,...")]
    at: Vec<String>,
    /// A quantity of which laws are made, counted as one symbol, such as cos(A/2); repeatable,
    /// those of the equation without it
    #[arg(long, value_name = "EXPRESSION", allow_hyphen_values = true)]
    atom: Vec<String>,
    /// The greatest length of a law in symbols
    #[arg(long, value_name = "N", value_parser = super::count, default_value_t = 24, allow_hyphen_values = true)]
    longest: u32,
    /// Keep the law exact at rest: its series is that of the true frequency up to this power of the
    /// variable, 0 for the frequency at rest alone
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    exact_at_rest: Option<u32>,
    /// Keep laws that grow as this power of the variable towards infinity, 1/2 say, whatever the range
    #[arg(long, value_name = "POWER", allow_hyphen_values = true)]
    growth: Option<String>,
    /// With JSON: the certificate of the law, which `check` reads, in place of the laws
    #[arg(long)]
    certificate: bool,
    #[command(flatten)]
    pub common: Common,
}

impl Work for ShortestArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn input(&self) -> Option<&Path> {
        super::problem::path(&self.problem)
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

/// The longest law that a search takes on.
const LONGEST: u32 = 60;

/// The highest power up to which a law is exact at rest.
const HIGHEST_ORDER: u32 = 12;

fn run(arguments: &ShortestArguments) -> Result<Outcome, Failure> {
    let common = &arguments.common;
    if common.tolerance.is_some() {
        return Err(Failure::Usage(
            "--tolerance: the error of a law is given by --error".to_owned(),
        ));
    }
    if arguments.longest > LONGEST {
        return Err(Failure::Usage(format!(
            "--longest {}: a law has at most {LONGEST} symbols",
            arguments.longest
        )));
    }
    if arguments.exact_at_rest.is_some_and(|order| order > HIGHEST_ORDER) {
        return Err(Failure::Usage(format!("--exact-at-rest: at most {HIGHEST_ORDER}")));
    }
    if arguments.certificate && common.format() != Format::Json {
        return Err(Failure::Usage(
            "--certificate is a JSON document: add --format json, or --output with a name that ends in .json".to_owned(),
        ));
    }
    let front = front(arguments)?;
    let report = ShortestReport::new(&front, arguments.error);
    let drawn = || Ok(drawing::picture(&report)?);
    let answer = Answer {
        document: &report::shortest(&report),
        width: width(common.output.as_deref()),
        picture: Some(&drawn as Draw),
        other: &|format| match format {
            Format::Json if arguments.certificate => certificate(&report),
            Format::Json => json_text(&json::shortest(&report)),
            Format::Csv => Ok(drawing::csv(&front)),
            Format::Code(language) => code::law(&report, language)
                .map_err(|error| Failure::with_advice(&error, error.help())),
            format => no_such(format),
        },
    };
    let outcome = answer.outcome(common)?;
    Ok(Outcome { verdict: report.verdict(), partial: front.is_partial, ..outcome })
}

/// The quantity that varies, and the ends of its range; `None` for infinity.
type Range = (Expr, Rational, Option<Rational>);

/// The laws by length.
fn front(arguments: &ShortestArguments) -> Result<Front, Failure> {
    let problem = arguments.contacts.on(problem(&arguments.problem)?)?;
    let range = range(&arguments.range)?;
    let is_contact = quantity(arguments) == LawQuantity::ContactTime;
    if let Some(equations) = coupled_equations(&problem, ReadingCommand::Shortest)? {
        if arguments.about.is_some() {
            return Err(Failure::Usage("--about: it is of one coordinate".to_owned()));
        }
        if is_contact {
            return Err(Failure::Usage(
                "--quantity contact-time: a contact has one coordinate".to_owned(),
            ));
        }
        return front_of_mode(arguments, equations, &problem, range);
    }
    for (option, given) in
        [("--mode", arguments.mode.is_some()), ("--amplitude", arguments.amplitude.is_some())]
    {
        if given {
            return Err(Failure::Usage(format!(
                "{option}: it is of the modes of coupled equations"
            )));
        }
    }
    match is_contact {
        true => front_of_contact(arguments, &problem, range),
        false => front_of_motion(arguments, &problem, range),
    }
}

fn refuse(error: ShortestError) -> Failure {
    match &error {
        ShortestError::Unknown(name) => Failure::Usage(format!("--at {name}: {error}")),
        _ => Failure::refused(&error, error.help()).of_kind(&error),
    }
}

/// The laws of the duration of a contact.
fn front_of_contact(
    arguments: &ShortestArguments,
    problem: &Problem,
    (varying, from, to): Range,
) -> Result<Front, Failure> {
    let oscillator = oscillator(&formula(problem, ReadingCommand::Shortest)?, None)?;
    let values = exact_values(&arguments.at, Ok(Values::default()))?.unwrap_or_default();
    let range = (&from, to.as_ref());
    let problem = LawProblem::of_contact(&oscillator, &varying, range, &values).map_err(refuse)?;
    searched(arguments, problem, &[])
}

/// The laws of the backbone of a normal mode.
fn front_of_mode(
    arguments: &ShortestArguments,
    equations: CoupledEquations,
    problem: &Problem,
    (varying, from, to): Range,
) -> Result<Front, Failure> {
    let number = arguments.mode.ok_or_else(|| {
        Failure::Usage("--mode: coupled equations have several modes: add --mode 1".to_owned())
    })?;
    let refused = |error: ModeError| refused(&error, problem.equation.as_deref());
    let system = free_system(equations, problem)?;
    let letters = system.letters;
    let _letters = letters.in_force();
    let own: Vec<Symbol> = varying.symbols().into_iter().collect();
    let of_file = problem.values_of_motion().map(|values| values.split(&own).1);
    let values = exact_values(&arguments.at, of_file)?.unwrap_or_default();
    let values = as_meant(&values, |name| system.resolve(name))?;
    let (values, others) = values.split(&system.equations.parameters);
    if let Some((name, _)) = others.iter().next() {
        return Err(refuse(ShortestError::Unknown(name)));
    }
    let system = system.with_values(&values).map_err(refused)?;
    let options = ModeOptions {
        mode: Some(number as usize),
        amplitude: arguments.amplitude.unwrap_or(AmplitudeConvention::FirstHarmonic),
        supervision: session::supervision(),
        ..ModeOptions::default()
    };
    let modes = derive(&system, &options).map_err(refused)?;
    let range = (&from, to.as_ref());
    let problem = LawProblem::of_mode(&modes, number as usize, &varying, range).map_err(refuse)?;
    searched(arguments, problem, &[])
}

/// The laws of free motions of one coordinate.
fn front_of_motion(
    arguments: &ShortestArguments,
    problem: &Problem,
    range: Range,
) -> Result<Front, Failure> {
    let typed = formula(problem, ReadingCommand::Shortest)?;
    let oscillator = oscillator(&typed, arguments.about.as_deref())?;
    let (varying, from, to) = range;
    // The range takes the place of a value of the file.
    let ranged: Vec<Symbol> = varying.symbols().into_iter().collect();
    let of_file = problem.values_of_motion().map(|values| values.split(&ranged).1);
    let values = exact_values(&arguments.at, of_file)?.unwrap_or_default();
    let own = oscillator.with_own_names_apart()?;
    let own_letters = own.letters();
    let resolved = |name: Symbol| own_letters.resolve(name, &own.parameters);
    let names = varying.symbols().into_iter();
    let varying =
        varying.substitute_all(&names.map(|name| (name, Expr::from(resolved(name)))).collect())?;
    let mut own_values = Values::default();
    for (name, value) in values.iter() {
        own_values.insert(resolved(name), value.clone())?;
    }
    let _letters = own_letters.in_force();
    let problem =
        LawProblem::new(&own, &varying, (&from, to.as_ref()), &own_values).map_err(refuse)?;
    let published = published(typed.equation, &problem, &values);
    searched(arguments, problem, &published)
}

/// The laws of a problem, with published formulas beside them.
fn searched(
    arguments: &ShortestArguments,
    problem: LawProblem,
    published: &[PublishedFormula],
) -> Result<Front, Failure> {
    let options = SearchOptions {
        quantity: quantity(arguments),
        atoms: atoms(arguments, &problem)?,
        longest: arguments.longest as usize,
        exact_at_rest: arguments.exact_at_rest,
        growth: arguments.growth.as_deref().map(growth).transpose()?,
    };
    let supervision = session::supervision();
    let found = with_progress("of the search", || search(problem, &options, supervision));
    Ok(found.map_err(refuse)?.beside(published))
}

/// The quantity that is asked for.
fn quantity(arguments: &ShortestArguments) -> LawQuantity {
    match arguments.quantity.as_str() {
        "omega^2" => LawQuantity::FrequencySquared,
        "T" => LawQuantity::Period,
        "contact-time" => LawQuantity::ContactTime,
        _ => LawQuantity::Frequency,
    }
}

/// The power of growth that is asked for.
fn growth(text: &str) -> Result<Rational, Failure> {
    let value = expression(text).ok().and_then(|value| value.as_number().cloned());
    let wrong = || Failure::Usage(format!("--growth {text}: expected a number such as 1/2 or -1"));
    value.ok_or_else(wrong)
}

/// The variable quantity and the ends of its range; `None` for infinity.
fn range(text: &str) -> Result<Range, Failure> {
    let form = || {
        Failure::Usage(format!(
            "--range {text}: expected NAME=FROM:TO, such as A=0:2.8, eps=0:10 or eps*A^2=0:inf"
        ))
    };
    let wrong = |error: &dyn std::fmt::Display| Failure::Usage(format!("--range {text}: {error}"));
    let (name, ends) = text.split_once('=').ok_or_else(form)?;
    let (from, to) = ends.split_once(':').ok_or_else(form)?;
    let name = expression(name).map_err(|error| wrong(&error))?;
    let number = |text: &str| {
        let value = expression(text).map_err(|error| wrong(&error))?;
        value.as_number().cloned().ok_or_else(form)
    };
    let to = match to.trim() {
        "inf" | "infinity" => None,
        to => Some(number(to)?),
    };
    Ok((name, number(from)?, to))
}

/// The quantities of which laws are made: the variable, and those that are asked for under letters of
/// their own.
fn atoms(arguments: &ShortestArguments, problem: &LawProblem) -> Result<Vec<Atom>, Failure> {
    if arguments.atom.is_empty() {
        return Ok(vec![]);
    }
    let own = Expr::from(problem.variable);
    let mut atoms = vec![Atom { name: problem.variable, meaning: Some(own) }];
    let mut taken = problem.coordinates();
    taken.extend([problem.variable, restitution()]);
    for text in &arguments.atom {
        let meaning =
            expression(text).map_err(|error| Failure::Usage(format!("--atom {text}: {error}")))?;
        if meaning.as_symbol() == Some(problem.variable) {
            continue;
        }
        if matches!(problem.motion, LawMotion::Contact { .. })
            && meaning.as_symbol() == Some(restitution())
        {
            atoms.push(Atom { name: restitution(), meaning: None });
            continue;
        }
        if meaning.symbols().into_iter().ne([problem.variable]) {
            let error = ShortestError::Atom(meaning, problem.variable);
            return Err(Failure::refused(&error, error.help()).of_kind(&error));
        }
        let name: Symbol = fresh("c", &taken);
        taken.push(name);
        atoms.push(Atom { name, meaning: Some(meaning) });
    }
    Ok(atoms)
}

/// The published formulas of an entry of the catalogue with this equation.
fn published(equation: &str, problem: &LawProblem, values: &Values) -> Vec<PublishedFormula> {
    let entry = catalog::CATALOG.iter().find(|entry| entry.equation == equation);
    let Some(entry) = entry.filter(|_| values.is_empty() && problem.meaning.is_none()) else {
        return vec![];
    };
    let own = catalog::RANGE_FORMULAS.iter().filter(|formula| formula.entry == entry.name);
    own.map(|formula| PublishedFormula {
        text: formula.period.to_owned(),
        quantity: LawQuantity::Period,
        source: formula.source.to_owned(),
    })
    .collect()
}

/// The certificate of the law that is shown first.
fn certificate(report: &ShortestReport) -> Result<String, Failure> {
    let law = report.shown().ok_or_else(|| Failure::because("no law was found"))?;
    match &law.proof {
        Ok((certificate, _)) => json_text(&json::law_certificate(certificate)),
        Err(reason) => Err(Failure::refused(
            &format!("there is no certificate: {reason}"),
            Some("leave out --certificate: the laws have their measured errors".to_owned()),
        )
        .of_kind(reason)),
    }
}

//! `lindstedt derive PROBLEM`.

use std::path::Path;

use std::time::Duration;

use crate::Values;
use crate::catalog::nearest;
use crate::export::code::{self, CodeStyle, Language};
use crate::export::{html, json, latex, text};
use crate::expr::{Expr, ResultSymbols, parse_expression};
use crate::method::table::{Choice, MethodEntry, that_take};
use crate::method::{self, Options, Reason, Refusal};
use crate::problem::{FormulaProblem, Order, Problem, ProblemError, ReadingCommand};
use crate::report;
use crate::solution::{AmplitudeConvention, Counts, Degrees, Method, Modulation, Note, Solution};
use crate::verify::{self, VerificationError};
use crate::{Oscillator, Symbol};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use super::answer::{Draw, drawn, no_such, page, pictured};
use super::files::width;
use super::problem::{coupled_equations, expression, problem, value_name};
use super::progress::with_progress;
use super::session::{self, Session};
use super::walls::ContactArguments;
use super::{
    Common, Failure, Format, Outcome, Work, in_flags, json_text, text_writer, tolerance, values_of,
};

/// An equation, and how it is to be answered.
#[derive(Args)]
pub struct EquationArguments {
    /// An equation in quotes, a TOML file, a name of the catalogue, or - for standard input
    pub problem: String,
    #[command(flatten)]
    contacts: ContactArguments,
    /// How to derive: lindstedt-poincare, homotopy-perturbation, homotopy-analysis,
    /// iteration-perturbation, parameter-expansion, harmonic-balance, energy-balance, max-min,
    /// amplitude-frequency, hamiltonian, variational-iteration, frequency-formula, averaging, pade,
    /// hermite-pade, multiple-scales or exact
    #[arg(long)]
    pub(super) method: Option<String>,
    /// Highest power of the small parameter kept, inclusive; harmonics of harmonic-balance; degrees
    /// L,M of pade, P,Q,R of hermite-pade
    #[arg(long, value_parser = order, allow_hyphen_values = true)]
    pub(super) order: Option<Order>,
    /// What the amplitude measures
    #[arg(long, value_parser = convention())]
    pub(super) amplitude: Option<AmplitudeConvention>,
    /// The small parameter; A for the amplitude
    #[arg(long, value_name = "NAME")]
    pub(super) small: Option<String>,
    /// The equilibrium to swing about, x=1 say: a stable one, without this the nearest to zero, or
    /// an unstable one between two wells for motions over both
    #[arg(long, value_name = "NAME=VALUE,...")]
    about: Option<String>,
    /// Degree of the Taylor polynomial that homotopy perturbation puts for the force
    #[arg(long, value_name = "DEGREE", value_parser = super::count, allow_hyphen_values = true)]
    taylor: Option<u32>,
    /// The convergence-control parameter of homotopy-analysis, exact; without it the best one is
    /// chosen at the values
    #[arg(long, allow_hyphen_values = true, value_name = "VALUE")]
    hbar: Option<String>,
    /// Which limit cycle of a self-excited equation, counted from 1 by amplitude; without it the
    /// smallest that attracts
    #[arg(long, value_name = "N", value_parser = super::count, allow_hyphen_values = true)]
    cycle: Option<u32>,
    /// Which resonance: of a driven equation Omega:omega0, 1:3 say, without it the one nearest to the
    /// values, or 1:1; of coupled equations relations between frequencies, "omega2 = 2*omega1,
    /// Omega = omega2", or none, without it those that the numbers are near
    #[arg(long, value_name = "P:Q")]
    pub(super) resonance: Option<String>,
    /// The frequency without the motion, of lindstedt-poincare: orders up to 2000, in less time
    #[arg(long)]
    omega_only: bool,
    /// Threads of a long expansion; all cores without it. The result is the same for any number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// A value, exact (1.5, 3/2, pi/3): asks for numbers and a verdict; repeatable
    #[arg(long, value_name = "NAME=VALUE,...")]
    pub(super) at: Vec<String>,
}

/// Derive the frequency law and the motion of an oscillator, to an order
#[derive(Args)]
pub struct DeriveArguments {
    #[command(flatten)]
    pub question: EquationArguments,
    /// Print the derivation, order by order, before the result; in JSON as `derivation`, in a
    /// program as a comment
    #[arg(long)]
    pub(super) steps: bool,
    /// Which normal mode of coupled equations, 1 for the slowest; without it all of them
    #[arg(long, value_name = "N", value_parser = super::count, allow_hyphen_values = true)]
    pub(super) mode: Option<u32>,
    #[command(flatten)]
    pub common: Common,
}

impl EquationArguments {
    /// Reads the problem, with its contacts.
    ///
    /// # Errors
    /// A PROBLEM or a contact that cannot be read.
    pub(super) fn problem(&self) -> Result<Problem, Failure> {
        self.contacts.on(problem(&self.problem)?)
    }

    /// Refuses options that the modes of coupled equations do not have.
    pub(super) fn check_of_modes(&self) -> Result<(), Failure> {
        let of_slow_equations =
            [("--small", self.small.is_some()), ("--resonance", self.resonance.is_some())];
        let given = of_slow_equations.into_iter().find(|(_, given)| *given);
        if let Some((option, _)) = given {
            return Err(Failure::Usage(format!(
                "{option}: of coupled equations it belongs to --method multiple-scales"
            )));
        }
        match self.of_one_coordinate() {
            Some(option) => Err(Failure::Usage(format!(
                "{option}: it is of one coordinate; the modes of coupled equations take --mode, --order, --amplitude and --at"
            ))),
            None => Ok(()),
        }
    }

    /// An option that is given and belongs to a single coordinate.
    pub(super) fn of_one_coordinate(&self) -> Option<&'static str> {
        let given = [
            ("--about", self.about.is_some()),
            ("--taylor", self.taylor.is_some()),
            ("--hbar", self.hbar.is_some()),
            ("--cycle", self.cycle.is_some()),
            ("--omega-only", self.omega_only),
        ];
        given.into_iter().find(|(_, given)| *given).map(|(option, _)| option)
    }
}

/// The names of the conventions, and the convention of each.
pub(super) fn convention() -> impl TypedValueParser<Value = AmplitudeConvention> {
    let names = [AmplitudeConvention::Initial, AmplitudeConvention::FirstHarmonic]
        .map(AmplitudeConvention::name);
    let unknown = || "no convention of this name".to_owned();
    PossibleValuesParser::new(names)
        .try_map(move |name| AmplitudeConvention::from_name(&name).ok_or_else(unknown))
}

/// A ratio of two whole numbers, `1:3`, in lowest terms.
fn ratio(text: &str) -> Result<(u32, u32), String> {
    let parts = text.split_once(':').and_then(|(above, below)| {
        let part =
            |text: &str| text.trim().parse::<u32>().ok().filter(|part| (1..=9).contains(part));
        part(above).zip(part(below))
    });
    let (above, below) = parts.ok_or("expected two whole numbers from 1 to 9, such as 1:3")?;
    let common = (1..=9).rev().find(|k| above % k == 0 && below % k == 0).unwrap_or(1);
    Ok((above / common, below / common))
}

/// Parses the argument of `--order`.
fn order(text: &str) -> Result<Order, String> {
    let number = |text: &str| {
        let text = text.trim();
        text.parse().map_err(|_| match text.starts_with('-') {
            true => format!("`{text}` is negative; an order is a whole number such as 2"),
            false => format!("`{text}` is no whole number"),
        })
    };
    let numbers: Vec<u32> = text.split(',').map(number).collect::<Result<_, String>>()?;
    match *numbers.as_slice() {
        [order] => Ok(Order::Power(order)),
        _ => {
            let degrees = Degrees::from_list(&numbers).map(Order::Degrees);
            degrees.ok_or_else(|| {
                "expected a whole number, or the degrees of an approximant".to_owned()
            })
        }
    }
}

/// An answer, with the equation that it is of and the values that are left once those that the
/// equation needs stand in it.
pub(super) struct Solved {
    pub oscillator: Oscillator,
    pub values: Option<Values>,
    pub solution: Solution,
    /// The letters of the answer.
    pub letters: ResultSymbols,
}

/// The convention of the amplitude: that of the option, else that of the file.
pub(super) fn amplitude(
    arguments: &EquationArguments,
    of_file: Option<&str>,
) -> Result<Option<AmplitudeConvention>, Failure> {
    match (arguments.amplitude, of_file) {
        (Some(convention), _) => Ok(Some(convention)),
        (None, None) => Ok(None),
        (None, Some(name)) => AmplitudeConvention::from_name(name).map(Some).ok_or_else(|| {
            Failure::Usage(format!(
                "unknown amplitude `{name}`\n  help: choose initial or first-harmonic"
            ))
        }),
    }
}

/// The answer to a problem, with the oscillator and the values that are left once those that the
/// equation needs stand in it.
pub(super) fn solved_problem(
    arguments: &EquationArguments,
    problem: &Problem,
) -> Result<Solved, Failure> {
    let formula = formula(problem, ReadingCommand::Derive)?;
    let oscillator = named(&oscillator(&formula, arguments.about.as_deref())?)?;
    let letters = oscillator.letters();
    let _letters = letters.in_force();
    let options = options(arguments, &formula, &oscillator)?;
    // The name is refused here, for a method that has no use for it would pass over it.
    if options.small.is_some() {
        oscillator
            .small_parameter(options.small.as_deref())
            .map_err(|error| Failure::with_advice(&error, error.help()))?;
    }
    let coordinate = oscillator.coordinate;
    let Numbered { oscillator, values, mut notes } =
        with_values(oscillator, &arguments.at, problem)?;
    // A name that is no function may be why the equation is refused.
    let misleading = notes.iter().filter(|note| matches!(note, Note::Misleading { .. }));
    let misleading: Vec<String> = misleading.map(Note::to_string).collect();
    let options = match &values {
        Some(values) => method::with_resonance_at(&oscillator, &options, values)
            .map_err(|refusal| refused(&oscillator, &refusal))?,
        None => options,
    };
    with_progress("of the calculation", || {
        on_threads(arguments.jobs, || {
            let _letters = letters.in_force();
            let (oscillator, values, mut solution) = solve_at(oscillator, values, &options)?;
            solution.convergence = verify::converges(&solution);
            notes.extend(notes_on_letters(&letters, coordinate, &solution, values.is_some()));
            solution.validity.extend(notes);
            let everywhere = verify::converges_everywhere(&solution);
            solution.validity.extend(everywhere);
            Ok(Solved { oscillator, values, solution, letters })
        })
    })
    .map_err(|failure: Failure| failure.with_notes(&misleading))
}

/// Refuses values that the formula does not have, and asks for those that it needs.
pub(super) fn check_values(solution: &Solution, values: &Values) -> Result<(), Failure> {
    verify::checked(solution, values).map_err(|error| unjudged(&error))
}

/// Why there is no verdict, with what to do about it.
pub(super) fn unjudged(error: &VerificationError) -> Failure {
    match error {
        VerificationError::Unknown { name, known } => {
            let near = nearest(name.written(), known.iter().map(|known| known.written()));
            let help = near.map(|near| format!("\n  help: did you mean `{near}`?"));
            Failure::Usage(format!("--at: {error}{}", help.unwrap_or_default()))
        }
        VerificationError::Missing(names) => Failure::refused(error, Some(values_of(names))),
        VerificationError::OffCycle => Failure::refused(
            error,
            Some("--method averaging follows the motion from A to the cycle".to_owned()),
        ),
        VerificationError::NeverRepeats => Failure::refused(
            error,
            Some(
                "leave the values out; `lindstedt simulate` follows the motion from any start"
                    .to_owned(),
            ),
        ),
        _ => Failure::refused(error, None),
    }
}

/// Refuses what asks for the motion where it is left out.
pub(super) fn with_motion(
    question: &EquationArguments,
    of_motion: &[(&str, bool)],
) -> Result<(), Failure> {
    match of_motion.iter().find(|(_, given)| question.omega_only && *given) {
        Some((what, _)) => Err(Failure::Usage(format!(
            "{what} asks for the motion, which --omega-only leaves out"
        ))),
        None => Ok(()),
    }
}

impl Work for DeriveArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn input(&self) -> Option<&Path> {
        super::problem::path(&self.question.problem)
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &DeriveArguments) -> Result<Outcome, Failure> {
    let problem = arguments.question.problem()?;
    if let Some(equations) = coupled_equations(&problem, ReadingCommand::Derive)? {
        if super::slow_equations::is_asked(arguments, &equations, &problem) {
            return super::slow_equations::run(arguments, equations, &problem);
        }
        arguments.question.check_of_modes()?;
        return super::modes::run(arguments, equations, &problem);
    }
    if arguments.mode.is_some() {
        return Err(Failure::Usage(
            "--mode: one coordinate has one mode; the modes of coupled equations are numbered"
                .to_owned(),
        ));
    }
    let of_motion = [
        ("--steps", arguments.steps),
        ("--plot", arguments.common.plot.is_some()),
        ("--format svg", arguments.common.format() == Format::Svg),
    ];
    with_motion(&arguments.question, &of_motion)?;
    let Solved { oscillator, values, solution, letters } =
        solved_problem(&arguments.question, &problem)?;
    let _letters = letters.in_force();
    let tolerance = tolerance(&arguments.common);
    let judged =
        values.is_some() || arguments.common.draws() || arguments.common.tolerance.is_some();
    let verification = match judged {
        false => None,
        true => {
            let judged =
                verify::judge(&oscillator, &solution, &values.unwrap_or_default(), tolerance);
            Some(judged.map_err(|error| unjudged(&error))?)
        }
    };
    let place = verification.as_ref().filter(|_| !arguments.question.omega_only);
    let draw = place.map(|verification| || picture(&oscillator, &solution, &verification.at));
    let picture = draw.as_ref().map(|draw| draw as Draw);
    let derivation = match arguments.common.format() {
        Format::Latex if arguments.steps => latex::steps(&solution),
        _ if arguments.steps => text::steps(&solution),
        _ => String::new(),
    };
    let text = match arguments.common.format() {
        Format::Text => {
            let space = if arguments.steps { "\n" } else { "" };
            let answer = text::solution(&solution, verification.as_ref());
            text::fitted(&(derivation + space + &answer), width(arguments.common.output.as_deref()))
        }
        Format::Html => {
            let document = report::solution(&solution, verification.as_ref());
            let derivation = Some((&solution, arguments.steps));
            page(picture, derivation, |page| html::document(&document, page))
        }
        Format::Svg => drawn(picture)?,
        Format::Latex => {
            let document = report::solution(&solution, verification.as_ref());
            arguments.common.latex(derivation + &latex::document(&document))
        }
        format @ (Format::Csv | Format::Toml) => no_such(format)?,
        Format::Json => {
            let mut document = json::solution(&solution, verification.as_ref());
            // The first line is the heading.
            document.derivation =
                arguments.steps.then(|| derivation.lines().skip(1).map(str::to_owned).collect());
            json_text(&document)?
        }
        Format::Code(language) => {
            let prefix = prefix(language, arguments.common.output.as_deref());
            let style = CodeStyle { language, prefix: &prefix };
            let program = code::solution(&oscillator, &solution, verification.as_ref(), style);
            let program = program.map_err(|reason| Failure::with_advice(&reason, reason.help()))?;
            let space = if derivation.is_empty() { "" } else { "\n" };
            language.comment(&(derivation + space)) + &program
        }
    };
    let asked = solution.validity.iter().find_map(|note| match note {
        Note::Stopped { asked } => Some(asked),
        _ => None,
    });
    Ok(Outcome {
        result: text_writer(text),
        picture: pictured(&arguments.common, picture),
        note: asked.map(|asked| {
            format!(
                "warning: stopped early, what there is is kept: order {} of {asked}",
                solution.order
            )
        }),
        verdict: verification.map(|verification| verification.verdict),
        partial: asked.is_some(),
    })
}

/// Does the work on this many threads, or on all.
fn on_threads<T: Send>(threads: Option<u16>, work: impl FnOnce() -> T + Send) -> T {
    let pool = threads
        .and_then(|count| rayon::ThreadPoolBuilder::new().num_threads(count.into()).build().ok());
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// The grace period after a timeout: an expansion that has begun has orders to show.
pub(super) fn grace_period(session: &Session) -> Duration {
    match session.progress.read() {
        (_, 0) => Duration::ZERO,
        _ => Duration::from_secs(60),
    }
}

/// The solution; where a limit cycle depends on the values of parameters, or letters stand in the
/// way, and values are given, that of the equation with those numbers in it.
fn solve_at(
    oscillator: Oscillator,
    values: Option<Values>,
    options: &Options,
) -> Result<(Oscillator, Option<Values>, Solution), Failure> {
    let refusal = match method::solve(&oscillator, options) {
        Ok(solution) => return Ok((oscillator, values, solution)),
        Err(refusal) => refusal,
    };
    let names: Vec<Symbol> = match &refusal.reason {
        Reason::LimitCycle { equation, .. } => equation.symbols().into_iter().collect(),
        Reason::SeveralVariables => oscillator.parameters.clone(),
        _ => vec![],
    };
    match values {
        Some(values) if !names.is_empty() => {
            let (known, rest) = values.split(&names);
            let oscillator = oscillator
                .with_values(&known)
                .map_err(|error| Failure::with_advice(&error, error.help()))?;
            let solution = method::solve(&oscillator, options)
                .map_err(|refusal| refused(&oscillator, &refusal))?;
            Ok((oscillator, Some(rest), solution))
        }
        _ => Err(refused(&oscillator, &refusal)),
    }
}

/// A refusal, with the term that it names shown in the equation.
pub(super) fn refused(oscillator: &Oscillator, refusal: &Refusal) -> Failure {
    let place = refusal.term().and_then(|term| oscillator.typed.locate(term));
    let shown = place.map_or(String::new(), |[line, carets]| format!("\n  {line}\n  {carets}"));
    let help = refusal.help().as_ref().map(in_flags);
    Failure::refused(&format!("{refusal}{shown}"), help).of_kind(refusal).naming(refusal.term())
}

/// Reads the equation and the choices of a problem for this command.
pub(super) fn formula(
    problem: &Problem,
    reader: ReadingCommand,
) -> Result<FormulaProblem<'_>, Failure> {
    problem.formula(reader).map_err(|error| Failure::refused(&error, error.help()))
}

/// The oscillator of an equation, about the equilibrium asked for.
pub(super) fn oscillator(
    formula: &FormulaProblem,
    about: Option<&str>,
) -> Result<Oscillator, Failure> {
    let oscillator = Oscillator::parse(formula.equation)
        .map_err(|error| Failure::with_advice(&error, error.help()).naming(error.term()))?;
    let Some(about) = about.or(formula.about) else {
        return Ok(oscillator);
    };
    let x = oscillator.coordinate;
    let usage = |message: String| Failure::Usage(format!("--about {about}: {message}"));
    let place =
        about.split_once('=').filter(|(name, _)| value_name(name) == x).ok_or_else(|| {
            usage(format!("expected {x}=VALUE, an equilibrium of the coordinate {x}"))
        })?;
    let value = expression(place.1).map_err(|error| usage(error.to_string()))?;
    let foreign =
        value.symbols().into_iter().find(|symbol| !oscillator.parameters.contains(symbol));
    match foreign {
        Some(symbol) => Err(usage(format!("`{symbol}` is no parameter of the equation"))),
        None => Ok(oscillator.about(value)),
    }
}

/// The oscillator with the names of its equation that are those of something in an answer kept
/// apart.
pub(super) fn named(oscillator: &Oscillator) -> Result<Oscillator, Failure> {
    oscillator.with_own_names_apart().map_err(|error| Failure::with_advice(&error, error.help()))
}

/// Notes on the letters that an answer takes in the place of usual ones, of those that it has; one
/// that is judged has a frequency.
pub(super) fn notes_on_letters(
    letters: &ResultSymbols,
    coordinate: Symbol,
    solution: &Solution,
    judged: bool,
) -> Vec<Note> {
    let slow = solution.modulation.as_ref();
    let begins = |slow: &Modulation| slow.release.is_some() && !slow.is_conservative();
    let released = slow.is_some_and(begins) || solution.in_time().is_some();
    let [start, harmonic] = [AmplitudeConvention::Initial, AmplitudeConvention::FirstHarmonic];
    let stands = |usual: Symbol| {
        if usual == start.symbol() {
            solution.amplitude == start || released
        } else if usual == harmonic.symbol() {
            solution.amplitude == harmonic
        } else {
            judged || solution.slow().is_none() && solution.in_time().is_none()
        }
    };
    let unusual = letters.renamed().filter(|(usual, _)| stands(*usual));
    let note = |(usual, written): (Symbol, Symbol)| Note::OtherLetter {
        usual,
        written,
        is_coordinate: usual.name() == coordinate.name(),
    };
    unusual.map(note).collect()
}

/// An oscillator with the values that are given, once those that its equilibrium needs stand in its
/// equation.
pub(super) struct Numbered {
    pub oscillator: Oscillator,
    pub values: Option<Values>,
    /// Notes on the names of parameters.
    pub notes: Vec<Note>,
}

/// The oscillator with the values of the command line and of the file.
pub(super) fn with_values(
    oscillator: Oscillator,
    at: &[String],
    problem: &Problem,
) -> Result<Numbered, Failure> {
    let values = exact_values(at, problem.values_of_motion())?;
    // A name that cancels in the equation of a mechanism may have a value, which changes nothing.
    let values = values.map(|values| values.split(&problem.cancelled).1);
    let values = values
        .filter(|values| !values.is_empty())
        .map(|values| as_meant(&values, |name| oscillator.resolve_symbol(name)))
        .transpose()?;
    let notes = notes_on_names(&oscillator, values.as_ref());
    let (oscillator, values) = with_known_equilibrium(oscillator, values)?;
    Ok(Numbered { oscillator, values, notes })
}

/// Notes on the names of parameters without a value that look like something else.
fn notes_on_names(oscillator: &Oscillator, values: Option<&Values>) -> Vec<Note> {
    let misleading = oscillator.misleading_parameters().into_iter();
    let without_value =
        |(name, _): &(Symbol, String)| values.is_none_or(|values| values.get(*name).is_none());
    misleading
        .filter(without_value)
        .map(|(name, instead)| Note::Misleading { name, instead })
        .collect()
}

/// The values under the names that they are meant for.
pub(super) fn as_meant(
    values: &Values,
    resolve: impl Fn(Symbol) -> Symbol,
) -> Result<Values, Failure> {
    let mut meant = Values::default();
    for (name, value) in values.iter() {
        meant
            .insert(resolve(name), value.clone())
            .map_err(|error| Failure::Usage(format!("--at: {error}")))?;
    }
    Ok(meant)
}

/// If the equilibrium in symbols is not that at the given numbers, returns the equation with those
/// numbers in it.
fn with_known_equilibrium(
    oscillator: Oscillator,
    values: Option<Values>,
) -> Result<(Oscillator, Option<Values>), Failure> {
    let Some(given) = values else {
        return Ok((oscillator, None));
    };
    let (known, rest) = given.split(&oscillator.parameters);
    let numerical = method::with_numbers_where_needed(&oscillator, &known)
        .map_err(|error| Failure::with_advice(&error, error.help()))?;
    Ok(match numerical {
        Some(numerical) => (numerical, Some(rest)),
        None => (oscillator, Some(given)),
    })
}

fn options(
    arguments: &EquationArguments,
    formula: &FormulaProblem,
    oscillator: &Oscillator,
) -> Result<Options, Failure> {
    let usage = |message: String| Err(Failure::Usage(message));
    let method = match arguments.method.as_deref().or(formula.method) {
        None => None,
        Some(name) => match Method::from_name(name) {
            Some(method) => Some(method),
            None => {
                return usage(format!("unknown method `{name}`\n  help: {}", methods_like(name)));
            }
        },
    };
    let amplitude = amplitude(arguments, formula.amplitude)?;
    let chosen = method.unwrap_or_else(|| method::default_method(oscillator));
    let without = |option: &str, owners: &str| {
        usage(format!(
            "{option} says nothing to --method {}: it belongs to {owners}",
            chosen.name()
        ))
    };
    let entry = MethodEntry::for_method(chosen);
    if arguments.taylor.is_some() && !entry.takes(Choice::Taylor) {
        return without("--taylor", &that_take(Choice::Taylor));
    }
    if arguments.cycle.is_some() && !entry.takes(Choice::Cycle) {
        return without("--cycle", &that_take(Choice::Cycle));
    }
    let resonance = arguments.resonance.as_deref().or(formula.resonance);
    if resonance.is_some() && !entry.takes(Choice::Resonance) {
        return without("--resonance", &that_take(Choice::Resonance));
    }
    if arguments.omega_only && !entry.takes(Choice::FrequencyAlone) {
        return without("--omega-only", &that_take(Choice::FrequencyAlone));
    }
    let (order, degrees) = match arguments.order.or(formula.order) {
        Some(_) if !entry.takes(Choice::Order) && !entry.takes(Choice::Degrees) => {
            return without("--order, or `order` in the file,", "the methods that approximate");
        }
        Some(Order::Degrees(_)) if !entry.takes(Choice::Degrees) => {
            return usage(format!("degrees are those of --method {}", that_take(Choice::Degrees)));
        }
        Some(order) if entry.takes(Choice::Degrees) => match (chosen.counts(), order.degrees()) {
            (Counts::Degrees(count), Some(degrees)) if degrees.list().len() == count => {
                (None, Some(degrees))
            }
            (Counts::Degrees(3), _) => {
                return usage(format!(
                    "--method {} takes three degrees: --order 2,2,2",
                    chosen.name()
                ));
            }
            _ => {
                return usage(format!("--method {} takes two degrees: --order 2,1", chosen.name()));
            }
        },
        Some(Order::Degrees(degrees)) => (None, Some(degrees)),
        Some(Order::Power(order)) => (Some(order), None),
        None => (None, None),
    };
    let hbar = match &arguments.hbar {
        None => None,
        Some(_) if !entry.takes(Choice::Hbar) => {
            return usage(format!("--hbar belongs to --method {}", that_take(Choice::Hbar)));
        }
        Some(text) => match parse_expression(text) {
            Ok(value) if value.as_number().is_some() => Some(value),
            Ok(_) => {
                return usage(format!("--hbar {text}: expected a fraction, such as -1 or -4/5"));
            }
            Err(error) => return usage(format!("--hbar {text}: {error}")),
        },
    };
    let small = arguments.small.as_deref().or(formula.small).map(str::to_owned);
    let resonance = resonance
        .map(|text| {
            ratio(text).map_err(|reason| Failure::Usage(format!("--resonance {text}: {reason}")))
        })
        .transpose()?;
    Ok(Options {
        method,
        order,
        amplitude,
        small,
        taylor: arguments.taylor,
        degrees,
        hbar,
        cycle: arguments.cycle,
        resonance,
        frequency_alone: arguments.omega_only,
        supervision: session::supervision(),
    })
}

/// The methods that a misspelt or shortened name may mean, or all.
fn methods_like(typed: &str) -> String {
    let typed = typed.to_lowercase().replace(['_', ' '], "-");
    let names = || Method::ALL.iter().map(|method| method.name());
    let close: Vec<&str> = names().filter(|name| name.contains(&typed)).collect();
    let close = match close.is_empty() {
        true => nearest(&typed, names()).into_iter().collect(),
        false => close,
    };
    match close.is_empty() {
        true => format!("choose one of {}", names().collect::<Vec<_>>().join(", ")),
        false => format!(
            "did you mean {}?",
            close.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" or ")
        ),
    }
}

/// The values of the command line, `A=1` or several of them, `A=1,eps=0.1`.
pub(super) fn given_values(at: &[String]) -> Result<Vec<(Symbol, Expr)>, Failure> {
    let mut values = vec![];
    for text in at {
        for part in separate_values(text) {
            let usage = |message: String| Failure::Usage(format!("--at {part}: {message}"));
            let Some((name, value)) = part.split_once('=') else {
                return Err(usage("expected NAME=VALUE, such as A=1.5".to_owned()));
            };
            if value.trim().is_empty() {
                let name = name.trim();
                return Err(usage(format!(
                    "a value is missing after `=`\n  help: --at {name}=1.5"
                )));
            }
            let value = expression(value).map_err(|error| usage(error.to_string()))?;
            values.push((value_name(name), value));
        }
    }
    Ok(values)
}

/// The parts of `A=1,eps=0.1`. A comma or a space before another name and its equals sign separates
/// two values; the comma of `max(1, 2)` does not.
pub(super) fn separate_values(text: &str) -> Vec<&str> {
    let mut ends: Vec<usize> = vec![];
    for (equals, _) in text.match_indices('=').skip(1) {
        let before = text[..equals].trim_end();
        let name = |letter: char| letter.is_alphanumeric() || letter == '_';
        let named = before.trim_end_matches(name);
        if named.len() < before.len() && named.ends_with([',', ';', ' ']) {
            ends.push(named.len());
        }
    }
    let begins = std::iter::once(0).chain(ends.iter().copied());
    let ends = ends.iter().copied().chain([text.len()]);
    let parts = begins.zip(ends).map(|(begin, end)| &text[begin..end]);
    parts.map(|part| part.trim_matches([',', ';', ' '])).collect()
}

/// The values of the command line, which win over those of the file; `None` if there are none at
/// all.
pub(super) fn exact_values(
    at: &[String],
    file: Result<Values, ProblemError>,
) -> Result<Option<Values>, Failure> {
    let mut values = Values::default();
    for (name, value) in given_values(at)? {
        values.insert(name, value).map_err(|error| Failure::Usage(format!("--at: {error}")))?;
    }
    let file = file.map_err(|error| Failure::refused(&error, error.help()))?;
    for (name, value) in
        file.iter().filter(|(name, _)| values.get(*name).is_none()).collect::<Vec<_>>()
    {
        values.insert(name, value.clone())?;
    }
    Ok((!values.is_empty()).then_some(values))
}

fn picture(
    oscillator: &Oscillator,
    solution: &Solution,
    values: &Values,
) -> Result<String, Failure> {
    use crate::export::figure::{MotionFigure, motion_figure};

    let motions = verify::motions(oscillator, solution, values)?;
    let Some(motions) = motions else {
        return Err(Failure::because(
            "the formula has no real frequency there, so it has no motion".to_owned(),
        ));
    };
    let at: Vec<String> = values.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    let caption = format!("{}; {}", solution.equation, at.join(", "));
    let label = solution.title();
    let figure = MotionFigure {
        coordinate: oscillator.coordinate.written(),
        displacement_unit: "",
        time_unit: "",
        formula_label: &label,
        formula: &motions.formula,
        truth: &motions.truth,
        envelopes: motions.envelope.as_ref().map_or(&[], |envelopes| envelopes.as_slice()),
        caption: &caption,
    };
    Ok(motion_figure(&figure)?)
}

/// The beginning of the names of functions, so that the programs of several files can be one: in C,
/// which has no modules, the name of the file.
pub(super) fn prefix(language: Language, output: Option<&Path>) -> String {
    let stem = output.and_then(|path| path.file_stem()?.to_str());
    match (language, stem) {
        (Language::C, Some(stem))
            if stem.starts_with(|first: char| first.is_ascii_alphabetic()) =>
        {
            stem.replace(|letter: char| !letter.is_ascii_alphanumeric(), "_") + "_"
        }
        _ => String::new(),
    }
}

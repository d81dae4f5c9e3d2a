//! A derived formula as a program: a small source file with the frequency, the displacement and the
//! velocity as functions.
//!
//! In: an answer, judged or not. Out: source text in one of the [`Language`]s. What a program
//! consists of is decided once, in `program.rs`; how an expression is written, and where a line is
//! broken, in `writer.rs`; a language is a `Syntax`, a file of its own in this folder: spellings,
//! and the functions that its library does not have.
//!
//! A program computes what [`evaluate`](crate::method::numbers::evaluate) does, by the law that is
//! judged. What cannot be written as a formula is refused; at given values its numbers can be
//! written.
//!
//! Nonlinear normal modes are programs too, with functions for each mode and coordinate.

mod c;
mod julia;
mod laws;
mod matlab;
mod modes;
mod program;
mod python;
mod rust;
mod writer;

use crate::expr::{Expr, Function};
use crate::oscillator::Oscillator;
use crate::report::{ModesReport, ShortestReport, shortest};
use crate::solution::{Advice, Setting, Solution};
use crate::symbol::Symbol;
use crate::verify::Verification;

/// A programming language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// Rust, with the standard library.
    Rust,
    /// C99, with the functions of `math.h`.
    C,
    /// Python 3, with the module `math`.
    Python,
    /// Julia, with the functions of `Base`.
    Julia,
    /// MATLAB and GNU Octave; everything takes arrays.
    Matlab,
}

impl Language {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Rust, Self::C, Self::Python, Self::Julia, Self::Matlab];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        self.syntax().name
    }

    /// A text as a comment, line by line; one that no documentation is made of.
    ///
    /// ```
    /// use lindstedt::export::code::Language;
    /// assert_eq!(Language::Python.comment("one\n\ntwo"), "# one\n#\n# two\n");
    /// ```
    pub fn comment(self, text: &str) -> String {
        commented(text, self.syntax().comment.trim_end_matches('!'))
    }

    fn syntax(self) -> &'static Syntax {
        match self {
            Self::Rust => &rust::SYNTAX,
            Self::C => &c::SYNTAX,
            Self::Python => &python::SYNTAX,
            Self::Julia => &julia::SYNTAX,
            Self::Matlab => &matlab::SYNTAX,
        }
    }
}

/// The reason why an answer has no program.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoCode {
    /// The frequency is solved for.
    #[error("no program: {0}")]
    SolvedByNumbers(String),
    /// The answer has no frequency at the values.
    #[error("no program: the formula has no motion at these values{}", .0.as_ref().map_or(String::new(), |reason| format!(": {reason}")))]
    NoMotion(Option<String>),
    /// The amplitude changes.
    #[error(
        "no program: the amplitude changes with time, and programs are written for periodic motions"
    )]
    Slow,
    /// A drive holds the motion.
    #[error("no program: a drive holds the motion, and programs are written for free ones")]
    Driven,
    /// A coefficient that no double can hold.
    #[error(
        "no program: a coefficient of the formula is beyond the range of double precision, 1.8e308"
    )]
    Beyond,
}

impl NoCode {
    /// A way forward.
    pub fn help(&self) -> Option<Advice> {
        match self {
            Self::SolvedByNumbers(_) => {
                let values = Advice::words("with values, by ").choose(Setting::Values);
                Some(values.then(", the program has the numbers that were found there"))
            }
            Self::Slow | Self::Driven => Some(Advice::words(
                "JSON has the formulas, and examples/read_slow_json.py makes the motion of them",
            )),
            Self::NoMotion(_) | Self::Beyond => None,
        }
    }
}

/// The language of a program, and the letters in front of the names of its functions, which keep
/// several programs apart in a language without modules.
///
/// ```
/// use lindstedt::export::code::{self, CodeStyle, Language};
/// use lindstedt::{Options, Oscillator, solve};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options::default())?;
/// let style = CodeStyle { language: Language::C, prefix: "pendulum_" };
/// let text = code::solution(&pendulum, &solution, None, style)?;
/// assert!(text.contains("double pendulum_displacement(double t, double A)"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CodeStyle<'a> {
    /// The language.
    pub language: Language,
    /// The beginning of the name of every function; may be empty.
    pub prefix: &'a str,
}

impl From<Language> for CodeStyle<'_> {
    fn from(language: Language) -> Self {
        Self { language, prefix: "" }
    }
}

/// The source text of an answer for `oscillator`: what is known of it as a comment, then
/// `angular_frequency`, `displacement` and `velocity`, formulas all with the same
/// arguments, behind the time of the motion. Where only numbers solve the law they are
/// those at the values of the verification.
///
/// # Errors
/// [`NoCode`], where the answer is not a formula for a periodic motion.
///
/// ```
/// use lindstedt::export::code::{self, Language};
/// use lindstedt::{Options, Oscillator, solve};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options { order: Some(2), ..Options::default() })?;
/// let text = code::solution(&pendulum, &solution, None, Language::Python)?;
/// assert!(text.contains("omega_squared = 1 - A**2/8"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solution<'a>(
    oscillator: &Oscillator,
    solution: &Solution,
    verification: Option<&Verification>,
    style: impl Into<CodeStyle<'a>>,
) -> Result<String, NoCode> {
    let _letters = solution.letters().in_force();
    let program = program::of_solution(oscillator, solution, verification)?;
    let CodeStyle { language, prefix } = style.into();
    writer::source(&program.with_prefix(prefix), language.syntax())
}

/// The source text of nonlinear normal modes: what is known of them as a comment, then for each mode
/// with a formula `mode1_angular_frequency`, and for each coordinate `mode1_displacement_x` and
/// `mode1_velocity_x`. All functions of a mode have the same arguments, behind the time of a motion.
///
/// # Errors
/// [`NoCode::Beyond`] for a coefficient that no double holds.
///
/// ```
/// use lindstedt::export::code::{self, Language};
/// use lindstedt::modes::{FreeSystem, ModeOptions, derive};
/// use lindstedt::report::ModesReport;
///
/// let pair = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0")?;
/// let found = derive(&pair, &ModeOptions::default())?;
/// let report = ModesReport { modes: &found, judged: &[], tolerance: 0.01 };
/// let text = code::modes(&report, Language::Python)?;
/// assert!(text.contains("omega_squared = 1 + 3*a**2/16 - 101*a**4/2048"), "{text}");
/// assert!(text.contains("def mode2_displacement_y(t, a):"), "{text}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn modes<'a>(report: &ModesReport, style: impl Into<CodeStyle<'a>>) -> Result<String, NoCode> {
    let _letters = report.modes.system.letters.in_force();
    let CodeStyle { language, prefix } = style.into();
    writer::source(&modes::program(report)?.with_prefix(prefix), language.syntax())
}

/// The source text of the frequency law that a search shows first: a function of its variable, with the
/// range and the proved bound of the error as a comment.
///
/// # Errors
/// [`NoCode`] where no law was found.
pub fn law<'a>(report: &ShortestReport, style: impl Into<CodeStyle<'a>>) -> Result<String, NoCode> {
    let CodeStyle { language, prefix } = style.into();
    let program = laws::program(report, &shortest(report))?;
    writer::source(&program.with_prefix(prefix), language.syntax())
}

/// A language: how everything looks in it.
struct Syntax {
    /// Its name on the command line.
    name: &'static str,
    /// The start of a comment.
    comment: &'static str,
    /// Names that no variable may have, beside those of the functions that a program calls.
    reserved: &'static [&'static str],
    /// The suffix of a whole number, such as `.0` if a number without a point is an integer.
    point: &'static str,
    /// pi.
    pi: &'static str,
    /// Product and quotient.
    operators: [&'static str; 2],
    /// The separators between values, of which arrays may be made.
    between_values: [&'static str; 2],
    /// A power.
    power: fn(&Base, Exponent) -> String,
    /// A function of the table; a leading point makes a method of it: `.cos`.
    function: fn(Function) -> &'static str,
    /// The text of a function that the library of the language does not have.
    helper: fn(Function) -> Option<&'static str>,
    /// The text before and after the value of a variable; the flag says whether the value is made
    /// of literal numbers alone.
    variable: fn(&str, bool) -> [String; 2],
    /// The text before and after a result.
    result: [&'static str; 2],
    /// The size of a variable in place of itself.
    size: fn(&str) -> String,
    /// The statement that keeps compilers from warning of an argument that is not used, where they
    /// do.
    unused: Option<fn(&str) -> String>,
    /// Ends a function without a value where a variable is not positive, for a reason in words;
    /// between them the variable that is spoilt where all of it is computed at once.
    positive: fn(&str, &str, &str) -> String,
    /// The way in which an expression longer than a line is broken.
    breaks: Break,
    /// The text before the functions: imports, and the frame of the program.
    beginning: fn(&UsedRoutines) -> String,
    /// A whole function.
    routine: fn(&Text) -> String,
}

/// A text as a comment, line by line.
fn commented(text: &str, prefix: &str) -> String {
    text.lines().map(|line| format!("{prefix} {line}").trim_end().to_owned() + "\n").collect()
}

/// The base of a power.
struct Base {
    /// The text of the base inside of other brackets.
    inside: String,
    /// As an operand.
    operand: String,
    /// Whether it is made of numbers written out alone.
    literal: bool,
}

/// The exponent of a power.
#[derive(Clone, Copy)]
enum Exponent<'a> {
    /// A whole number above one.
    Whole(&'a str),
    /// One half.
    Half,
    /// A fraction with an odd denominator, to which every real number has a power; whether its
    /// numerator is odd.
    OddRoot(&'a str, bool),
    /// Anything else: no power of a negative number.
    Real(&'a str),
}

/// The way in which long expressions are broken.
enum Break {
    /// Before a sign.
    BeforeSigns,
    /// Before a sign, in parentheses.
    InParentheses,
    /// After a sign, with this at the end of the line.
    AfterSigns(&'static str),
}

/// The functions of a program, to which its beginning is adapted.
struct UsedRoutines<'a> {
    /// Its text.
    text: &'a str,
    /// The functions that it consists of.
    routines: &'a [&'a str],
}

impl UsedRoutines<'_> {
    /// Whether this word stands in the text.
    fn has(&self, word: &str) -> bool {
        let inside = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        self.text.match_indices(word).any(|(place, _)| {
            let before = self.text[..place].chars().next_back();
            let after = self.text[place + word.len()..].chars().next();
            !before.is_some_and(inside) && !after.is_some_and(inside)
        })
    }
}

/// A function as text.
struct Text<'a> {
    name: &'a str,
    about: &'a str,
    arguments: &'a [String],
    /// Its lines: variables, conditions and the result.
    lines: &'a [String],
}

/// A program, whatever its language.
struct Program {
    /// The comment in front of it, line by line.
    header: Vec<String>,
    routines: Vec<Routine>,
}

impl Program {
    /// Puts these letters in front of the name of every function.
    fn with_prefix(mut self, prefix: &str) -> Self {
        for routine in &mut self.routines {
            routine.name.insert_str(0, prefix);
            for statement in &mut routine.body {
                if let Statement::Variable(_, Value::Call(name, _)) = statement {
                    name.insert_str(0, prefix);
                }
            }
        }
        self
    }
}

/// A function of numbers.
struct Routine {
    name: String,
    /// Its description in words.
    about: String,
    arguments: Vec<Symbol>,
    body: Vec<Statement>,
    result: Value,
}

/// A statement of a function before its result.
enum Statement {
    /// A variable.
    Variable(Symbol, Value),
    /// The size of an argument replaces it from here on.
    Size(Symbol),
    /// Without this being positive there is no value, for the reason given; what the value is
    /// computed with is the second.
    Positive(Symbol, Symbol, String),
    /// An argument that the function does not need.
    Unused(Symbol),
}

/// The value that a function returns.
#[derive(Clone)]
enum Value {
    /// An expression.
    Expression(Expr),
    /// Terms in this order.
    Sum(Vec<Value>),
    /// Several values, each on a line of its own if there is more than one line.
    Lines(Vec<Value>),
    /// Factors in this order.
    Product(Vec<Value>),
    /// A function of the program.
    Call(String, Vec<Symbol>),
}

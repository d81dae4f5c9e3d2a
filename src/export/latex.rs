//! Documents as LaTeX: equations, tables, and the remaining text as comments.
//!
//! In come a result or its document of [`report`], or an expression alone; out goes text to be
//! pasted into an article. The numbers are those of the text format.
//!
//! The output uses `amsmath`, and `longtable` for a table that may be longer than a page, and nothing
//! else: `align*`, `\frac`, `\sqrt`, `\left( \right)`, Greek letters and the named functions.

pub(super) mod comparison;
mod expression;
mod impact;
pub(in crate::export) mod rows;
mod table;

pub use expression::{expression, inside, symbol};
pub(super) use table::LatexTable;

pub use super::steps::latex as steps;
use std::collections::BTreeMap;

use num_traits::Zero;

use crate::decimal::{decimal, rounded_fraction};
use crate::exact::{Polynomial, Polynomials};
use crate::expr::{Equation, Expr, parse_expression};
use crate::impact::PhaseReading;
use crate::report::{self, Block, Document};
use crate::series::FourierSeries;
use crate::series::terms::{self, Notation};
use crate::solution::{Solution, Sum, long_fraction};
use crate::symbol::Symbol;
use crate::symbol::letters::{FREQUENCY, of_frequency};
use crate::verify::comparison::{Comparison, Refused};
use crate::verify::{Verdict, Verification};

/// A sum with its terms in order.
pub(super) fn sum(sum: &Sum) -> String {
    let exact = |term: &Polynomial| expression(&Expr::from(term));
    let decimal = |number: &str, rest: Option<&Polynomial>| match rest {
        None => scientific_text(number),
        Some(rest) => format!("{}\\,{}", scientific_text(number), exact(rest)),
    };
    sum.written(exact, decimal)
}

/// A constant; a number that must be rounded is printed with fifteen digits.
fn constant(value: &Expr) -> String {
    match long_fraction(value) {
        Some(number) => expression(&Expr::number(rounded_fraction(number, 15))),
        None => expression(value.with_number_under_root().as_ref().unwrap_or(value)),
    }
}

pub(super) fn scientific(value: f64) -> String {
    scientific_text(&decimal(value))
}

pub(super) fn scientific_text(text: &str) -> String {
    match text.split_once('e') {
        None => text.to_owned(),
        Some((mantissa, exponent)) => format!("{mantissa} \\cdot 10^{{{exponent}}}"),
    }
}

/// An equation, `left = right`.
///
/// ```
/// use lindstedt::{export::latex, expr::parse_equation};
///
/// assert_eq!(latex::equation(&parse_equation("x'' + x^3/2 = 0")?), r"\ddot{x} + \frac{x^{3}}{2} = 0");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn equation(equation: &Equation) -> String {
    format!("{} = {}", expression(&equation.left), expression(&equation.right))
}

/// An equation, `left = right`, or an expression, as it was typed.
///
/// ```
/// assert_eq!(lindstedt::export::latex::typed("omega0^2*x"), r"\omega_{0}^{2} x");
/// ```
pub fn typed(text: &str) -> String {
    let side =
        |text: &str| with_decimals(text).map_or_else(|| text.to_owned(), |side| expression(&side));
    match text.split_once('=') {
        Some((left, right)) => format!("{} = {}", side(left), side(right)),
        None => side(text),
    }
}

/// The expression of a text whose decimals are kept as they are written, as symbols of their own; `None` if it
/// cannot be read.
fn with_decimals(text: &str) -> Option<Expr> {
    let mut names: BTreeMap<Symbol, Expr> = BTreeMap::new();
    let (mut renamed, mut rest) = (String::new(), text);
    while let Some(begin) = rest.find(|letter: char| letter.is_ascii_digit() || letter == '.') {
        let end = rest[begin..].find(|letter: char| !letter.is_ascii_digit() && letter != '.');
        let end = end.map_or(rest.len(), |end| begin + end);
        let digits = &rest[begin..end];
        let in_name =
            rest[..begin].ends_with(|letter: char| letter.is_alphanumeric() || letter == '_');
        // Powers with a decimal as exponent are roots, which are written as such.
        let is_exponent = rest[end..].starts_with(['e', 'E'])
            || rest[..begin].trim_end_matches('(').ends_with('^');
        renamed.push_str(&rest[..begin]);
        match digits.contains('.') && !in_name && !is_exponent {
            true => {
                let name = Symbol::new(&format!("decimal_{}", names.len()));
                renamed.push_str(name.name());
                names.insert(name, Expr::symbol(digits));
            }
            false => renamed.push_str(digits),
        }
        rest = &rest[end..];
    }
    parse_expression(&(renamed + rest)).ok()?.substitute_all(&names).ok()
}

/// Words that are a formula, such as `1 - A^2/8` or `x'' + sin(x) = 0`, as LaTeX; `None` if they
/// are plain words.
pub(super) fn formula_in_words(words: &str) -> Option<String> {
    let signs = ["^", "*", "(", " + ", " - ", " = "];
    let is_formula = signs.iter().any(|sign| words.contains(sign))
        && words.split('=').count() <= 2
        && words.split('=').all(|side| parse_expression(side).is_ok());
    is_formula.then(|| typed(words))
}

/// The derived formula, and its verification if there is one, to be pasted into an article.
///
/// ```
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// let article = lindstedt::export::latex::solution(&solution, None);
/// assert!(article.contains(r"\begin{align*}") && article.contains(r"\omega^{2}"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solution(solution: &Solution, verification: Option<&Verification>) -> String {
    let _letters = solution.letters().in_force();
    document(&report::solution(solution, verification))
}

/// Every method in one table; those that do not apply are listed in comments below it.
///
/// ```
/// use lindstedt::{Oscillator, verify::comparison::compare};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let table = compare(&pendulum, &"A = 1".parse()?, None, 0.01)?;
/// assert!(lindstedt::export::latex::comparison(&table).contains(r"\begin{longtable}"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn comparison(comparison: &Comparison) -> String {
    let _letters = comparison.letters().in_force();
    document(&report::comparison(comparison))
}

/// A document as LaTeX: comments, the equations in one `align*`, and each table at its place.
///
/// ```
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// let document = lindstedt::report::solution(&solution, None);
/// assert_eq!(lindstedt::export::latex::document(&document), lindstedt::export::latex::solution(&solution, None));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn document(document: &Document) -> String {
    let mut page = LatexPage::default();
    for block in document.sections.iter().flatten() {
        page.add(block);
    }
    page.flush();
    page.text
}

/// The packages that equations and tables need in an article.
pub fn packages(text: &str) -> &'static str {
    match text.contains("\\begin{longtable}") {
        true => "\\usepackage{amsmath,longtable}",
        false => "\\usepackage{amsmath}",
    }
}

/// Equations and tables as a complete document, which compiles as it is.
///
/// ```
/// let document = lindstedt::export::latex::standalone("\\begin{align*}\nx &= 1\n\\end{align*}\n");
/// assert!(document.starts_with("\\documentclass{article}") && document.contains("amsmath"));
/// ```
pub fn standalone(text: &str) -> String {
    // A displayed equation may take more than a page.
    let packages = packages(text);
    format!(
        "\\documentclass{{article}}\n{packages}\n\\allowdisplaybreaks\n\\begin{{document}}\n\n{text}\n\\end{{document}}\n"
    )
}

/// The rank of a comment among those of one group.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    Note,
    Remark,
    Verdict,
}

/// A relation, with zero on the left.
fn zero_is(relation: &Sum) -> String {
    let mut polynomial = Polynomial::zero();
    for (monomial, number) in relation.terms() {
        polynomial.add_term(monomial.clone(), number.clone());
    }
    format!("0 &= {}", expression(&Expr::from(&polynomial)))
}

/// A method that does not apply, and the reason.
fn not_applicable(refused: &Refused) -> String {
    format!("not applicable: {}: {}", refused.method.title(), refused.reason)
}

/// The verdict on every column.
fn in_one_line(verdicts: &[(PhaseReading, Verdict)]) -> String {
    let each: Vec<String> = verdicts
        .iter()
        .map(|(reading, verdict)| format!("{} {}", reading.name(), verdict.name()))
        .collect();
    format!("verdict: {}", each.join(", "))
}

/// The text written so far, and the parts that wait for the end or for the next table.
#[derive(Default)]
struct LatexPage {
    text: String,
    comments: Vec<(Rank, String)>,
    questions: Vec<String>,
    laws: Vec<String>,
    rows: Vec<String>,
}

/// The typesetting of a block.
pub(super) enum Setting {
    /// Rows of `align*`.
    Equations(Vec<String>),
    /// A table.
    Table(LatexTable),
    /// Words.
    Words,
}

/// The typesetting of a block, in LaTeX and in other formats that use its formulas: long equations
/// in several rows.
pub(super) fn setting(block: &Block) -> Setting {
    match unbroken(block) {
        Setting::Equations(formulas) => {
            Setting::Equations(formulas.iter().flat_map(|formula| rows::rows(formula)).collect())
        }
        setting => setting,
    }
}

/// The typesetting of a block, with each equation in one row.
fn unbroken(block: &Block) -> Setting {
    let equation_of =
        |left: String, right: String| Setting::Equations(vec![format!("{left} &= {right}")]);
    match block {
        Block::Question(question) => {
            Setting::Equations(vec![equation(question).replacen(" = ", " &= ", 1)])
        }
        Block::QuestionAsTyped(question) => {
            Setting::Equations(vec![typed(question).replacen(" = ", " &= ", 1)])
        }
        Block::Law { left, right } if left.is_zero() => Setting::Equations(vec![zero_is(right)]),
        Block::Law { left, right } => equation_of(expression(left), sum(right)),
        Block::Equality { left, right } => equation_of(expression(left), expression(right)),
        Block::Line(line) => Setting::Equations(super::steps::line_as_latex(line.as_ref())),
        Block::CycleAmplitude { symbol: name, amplitude } => {
            equation_of(symbol(*name), sum(amplitude))
        }
        Block::Motion(solution) => Setting::Equations(motion(solution)),
        Block::Harmonics { coordinate, series, amplitude, rounded, phase } => {
            let law = |coefficient: &Polynomial| {
                sum(&Sum::new(coefficient, *rounded, |term| term.exponent(*amplitude)))
            };
            let waves = terms::waves(series, law, &NOTATION, *phase);
            let waves = if waves.is_empty() { vec!["0".to_owned()] } else { waves };
            let first = format!("{}(t) &= ", symbol(*coordinate));
            Setting::Equations(terms::lines(&waves, &first, "&\\quad "))
        }
        Block::Definition(definition) => {
            equation_of(symbol(definition.symbol), constant(&definition.meaning))
        }
        Block::Value { name, value, .. } => equation_of(symbol(*name), scientific(*value)),
        Block::Reading { reading, .. } => Setting::Equations(vec![impact::reading(*reading)]),
        Block::Fitted { fitted, barrier, rule, letters, per_stiffness } => Setting::Equations(
            vec![impact::fitted(fitted, *barrier, *rule, *letters, *per_stiffness)],
        ),
        Block::Phase { phase, letters, .. } => Setting::Equations(impact::phase(phase, *letters)),
        Block::SiValue { name, formula, value, unit, .. } => {
            Setting::Equations(vec![impact::si_value(name, *formula, *value, unit)])
        }
        Block::Table { head, rows } => Setting::Table(table::table(head, rows)),
        Block::ClosedForms(pieces) => Setting::Table(super::simulation::phases_as_table(pieces)),
        Block::Methods { rows, at, .. } => Setting::Table(comparison::methods(rows, at)),
        Block::Quantities { columns, rows, .. } => {
            Setting::Table(impact::quantities(columns, rows))
        }
        Block::ContactLaws { rows } => Setting::Table(impact::contact_laws(rows)),
        Block::ImpactMethods { rows, truth, .. } => Setting::Table(impact::methods(rows, *truth)),
        Block::SiQuantities { columns, rows } => {
            Setting::Table(impact::si_quantities(columns, rows))
        }
        Block::Title { .. }
        | Block::Heading(_)
        | Block::Note(_)
        | Block::Remark(_)
        | Block::Sentence(_)
        | Block::Detail(_)
        | Block::Entries { .. }
        | Block::Facts(_)
        | Block::Judged { .. }
        | Block::Truth { .. }
        | Block::Refused(_)
        | Block::TrueMotion(_)
        | Block::Closing(_)
        | Block::Verdicts { .. } => Setting::Words,
    }
}

impl LatexPage {
    fn add(&mut self, block: &Block) {
        // Each of several answers has equations of its own.
        let is_next = matches!(block, Block::Title { .. });
        if is_next && !(self.laws.is_empty() && self.rows.is_empty()) {
            self.flush();
        }
        // Rows are broken where all of them are known, because they are aligned.
        match (unbroken(block), block) {
            (Setting::Table(table), _) => {
                self.flush();
                self.text.push_str(&table.written());
            }
            (Setting::Equations(rows), Block::Question(_) | Block::QuestionAsTyped(_)) => {
                self.questions.extend(rows)
            }
            (Setting::Equations(rows), Block::Law { left, .. }) if !left.is_zero() => {
                self.laws.extend(rows)
            }
            (Setting::Equations(rows), _) => self.rows.extend(rows),
            (Setting::Words, _) => {}
        }
        self.write_words(block);
    }

    /// The words of a block, as comments; other words are left out, because an article has its own.
    fn write_words(&mut self, block: &Block) {
        match block {
            Block::Title { words, amplitude } => {
                self.comment(Rank::Note, format!("{words}; {amplitude}"))
            }
            Block::Note(words) | Block::Sentence(words) => self.comment(Rank::Note, words.clone()),
            Block::Remark(words) => self.comment(Rank::Remark, words.clone()),
            Block::Value { name, source: Some(source), .. } => {
                self.comment(Rank::Note, format!("{name}: {source}"))
            }
            Block::Judged { verification, series_of_omega, .. } => {
                self.comment(Rank::Verdict, judged(verification, *series_of_omega))
            }
            Block::Truth { equation, frequency, .. } => {
                self.comment(Rank::Note, comparison::truth(equation, frequency))
            }
            Block::Facts(facts) => {
                let facts = facts.iter().map(|(name, value)| format!("{name}: {value}"));
                self.comments(Rank::Remark, facts);
            }
            Block::Refused(refused) => {
                self.comments(Rank::Note, refused.iter().map(not_applicable))
            }
            Block::TrueMotion(lines) => self.comments(Rank::Note, lines.iter().cloned()),
            Block::Verdicts { verdicts, .. } => self.comment(Rank::Verdict, in_one_line(verdicts)),
            _ => {}
        }
    }

    fn comment(&mut self, rank: Rank, words: String) {
        self.comments.push((rank, words));
    }

    fn comments(&mut self, rank: Rank, lines: impl Iterator<Item = String>) {
        lines.for_each(|words| self.comment(rank, words));
    }

    /// Writes the pending comments, and the equations with the laws after the equation of motion.
    fn flush(&mut self) {
        let mut comments = std::mem::take(&mut self.comments);
        comments.sort_by_key(|comment| comment.0);
        self.text.extend(comments.iter().map(|(_, words)| format!("% {words}\n")));
        let mut rows = std::mem::take(&mut self.questions);
        rows.append(&mut self.laws);
        rows.append(&mut self.rows);
        if !rows.is_empty() {
            let rows = rows::aligned(&rows).join(" \\\\\n");
            self.text.push_str(&format!("\\begin{{align*}}\n{rows}\n\\end{{align*}}\n"));
        }
    }
}

/// The verdict in one line.
fn judged(verification: &Verification, series_of_omega: Option<f64>) -> String {
    let error = verification.relative_error.map(|error| match error.abs() < 1e-9 {
        true => super::text::percent(error),
        false => decimal(100.0 * error) + " %",
    });
    let other = series_of_omega
        .map(|other| format!("; of the series of {FREQUENCY} itself {} %", decimal(100.0 * other)));
    format!(
        "true {FREQUENCY} {}, relative error {} (by {}{}), verdict {}",
        decimal(verification.true_frequency),
        error.as_deref().unwrap_or("none"),
        of_frequency(verification.judged_on),
        other.unwrap_or_default(),
        verification.verdict_on_both().unwrap_or_else(|| verification.verdict.name().to_owned())
    )
}

/// The notation of harmonics in LaTeX.
pub(super) const NOTATION: Notation = Notation {
    wave: |function, k, phase| match k {
        1 => format!("\\{function} {}", symbol(phase)),
        _ => format!("\\{function} {k}{}", symbol(phase)),
    },
    times: " ",
    brackets: ["\\left(", "\\right)"],
};

pub(super) fn waves(series: &FourierSeries<Polynomials>, solution: &Solution) -> Vec<String> {
    terms::waves(
        series,
        |coefficient| sum(&solution.ordered(coefficient)),
        &NOTATION,
        solution.phase(),
    )
}

/// The motion, one harmonic a line; empty if only quadrature gives it.
fn motion(solution: &Solution) -> Vec<String> {
    let coordinate = symbol(solution.coordinate());
    if let Some(motion) = &solution.closed_motion {
        return vec![format!("{coordinate}(t) &= {}", expression(motion))];
    }
    if solution.displacement.is_zero() {
        return vec![];
    }
    let waves = waves(&solution.displacement, solution);
    let mut lines = terms::lines(&waves, &format!("{coordinate}(t) &= "), "&\\quad ");
    lines.push(format!("{} &= {}", symbol(solution.phase()), angle(solution)));
    lines
}

/// The phase of a motion.
fn angle(solution: &Solution) -> String {
    let Some(slow) = solution.slow() else {
        return format!("{} t", symbol(FREQUENCY));
    };
    let phase = Expr::from(slow.phase);
    let Some(resonance) = &slow.resonance else {
        return expression(&phase);
    };
    let driven = Expr::from(i64::from(resonance.times_driving))
        * &resonance.driving_frequency
        * Expr::symbol("t");
    let angle = Expr::divide(&(driven - phase), &Expr::from(i64::from(resonance.times_linear)));
    angle.map_or_else(|_| String::new(), |angle| expression(&angle))
}

/// Running text inside `\\text{...}`.
pub(super) fn words(text: &str) -> String {
    let mut escaped = String::new();
    for letter in text.chars() {
        match letter {
            '%' | '&' | '#' | '$' | '_' | '{' | '}' => escaped.extend(['\\', letter]),
            '^' => escaped.push_str("\\^{}"),
            '<' | '>' => escaped.extend(['$', letter, '$']),
            '\\' | '~' => escaped.push(' '),
            _ => escaped.push(letter),
        }
    }
    escaped
}

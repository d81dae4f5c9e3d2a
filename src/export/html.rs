//! Documents as a page that stands alone: one file with its formulas, tables and picture in it, for
//! a browser or a printer.
//!
//! In come a document of [`report`](crate::report), or a text, and what belongs on its page; out
//! goes HTML. Formulas are those of the LaTeX format, set as MathML Core, which browsers draw
//! without help; nothing is loaded from anywhere. The page is the same byte for byte on every run.

mod math;
mod words;

use math::Typesetter;
use words::{definitions, list, verdict};

use super::latex::{self, LatexTable, Setting};
use super::{escaped, steps, text};
use crate::decimal::significant;
use crate::expr::parse_equation;
use crate::report::{Block, Document, MethodRow};
use crate::solution::Solution;
use crate::verify::comparison::Refused;

/// The parts of a page beside its document.
#[derive(Clone, Copy, Debug, Default)]
pub struct HtmlPage<'a> {
    /// The title that a browser shows.
    pub title: &'a str,
    /// A picture as SVG, or why there is none.
    pub picture: Option<Result<&'a str, &'a str>>,
    /// The answer whose derivation can be unfolded, and whether it is unfolded from the start.
    pub derivation: Option<(&'a Solution, bool)>,
    /// The command that made the page and can be typed again.
    pub made_by: &'a str,
}

/// A document as a page.
///
/// ```
/// use lindstedt::export::html::{self, HtmlPage};
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// let document = lindstedt::report::solution(&solution, None);
/// let page = html::document(&document, &HtmlPage { title: "Duffing", ..HtmlPage::default() });
/// assert!(page.starts_with("<!doctype html>") && page.contains("<math"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn document(document: &Document, page: &HtmlPage) -> String {
    let typesetter = Typesetter::default();
    let mut body =
        Body { typesetter: &typesetter, text: String::new(), rows: Vec::new(), titled: false };
    for section in &document.sections {
        section.iter().for_each(|block| body.add(block));
        body.flush();
    }
    let derivation = page.derivation.map(|(solution, open)| (steps::rows(solution), open));
    if let Some((rows, open)) = derivation.filter(|(rows, _)| !rows.is_empty()) {
        let open = if open { " open" } else { "" };
        let rows = typesetter.display(&rows);
        body.text.push_str(&format!(
            "<details{open}>\n<summary>Derivation</summary>\n{rows}</details>\n"
        ));
    }
    let heading = match body.titled {
        true => String::new(),
        false => heading(page),
    };
    page_around(&(heading + &body.text), page)
}

/// The heading of a page that has no equation as its own.
fn heading(page: &HtmlPage) -> String {
    match page.title {
        "" => String::new(),
        title => format!("<h1>{}</h1>\n", escaped(title)),
    }
}

/// A report that is a text, as a page: its equations set, the first lines of its paragraphs as
/// headings, and what is indented below them as it is.
///
/// ```
/// use lindstedt::export::html::{self, HtmlPage};
///
/// let page = html::lines("a < b\n", &HtmlPage::default());
/// assert!(page.contains("<pre>a &lt; b\n</pre>"));
/// ```
pub fn lines(text: &str, page: &HtmlPage) -> String {
    let typesetter = Typesetter::default();
    let mut body = heading(page);
    for paragraph in text.split_inclusive("\n\n") {
        let mut rest = paragraph.trim_end_matches('\n');
        while let Some((line, others)) = split_equation(rest) {
            body += &typesetter.display(&[latex::typed(line)]);
            rest = others;
        }
        if let Some((line, others)) = rest.split_once('\n')
            && !line.starts_with(' ')
            && others.starts_with(' ')
        {
            body += &format!("<h3>{}</h3>\n", escaped(line));
            rest = others;
        }
        if !rest.is_empty() {
            body += &format!("<pre>{}\n</pre>\n", escaped(rest));
        }
    }
    page_around(&body, page)
}

/// The first line, where it is an equation of motion, and the others.
fn split_equation(text: &str) -> Option<(&str, &str)> {
    let (line, others) = text.split_once('\n').unwrap_or((text, ""));
    let line = line.trim();
    let is_equation = line.contains("''") && parse_equation(line).is_ok();
    is_equation.then_some((line, others))
}

/// A table as a page: its cells are LaTeX of running text.
pub(super) fn table(table: &LatexTable, page: &HtmlPage) -> String {
    let typesetter = Typesetter::default();
    let mut body =
        Body { typesetter: &typesetter, text: heading(page), rows: vec![], titled: true };
    body.table(table);
    page_around(&body.text, page)
}

/// The page around its body.
fn page_around(body: &str, page: &HtmlPage) -> String {
    let picture = match page.picture {
        Some(Ok(picture)) => format!("<figure>\n{}\n</figure>\n", scaled(picture)),
        Some(Err(reason)) => format!("<p class=\"soft\">No picture: {}</p>\n", escaped(reason)),
        None => String::new(),
    };
    let title = escaped(page.title);
    let made_by = match page.made_by {
        "" => String::new(),
        command => format!("<code>{}</code>, ", escaped(command)),
    };
    let (version, style) = (env!("CARGO_PKG_VERSION"), include_str!("html/page.css"));
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>\n{style}</style>\n</head>\n<body>\n<main>\n{body}{picture}\
         <footer>{made_by}lindstedt {version}</footer>\n</main>\n</body>\n</html>\n"
    )
}

/// A picture that may become narrower than it was drawn.
fn scaled(picture: &str) -> String {
    let attribute = |name: &str| {
        let (_, rest) = picture.split_once(&format!(" {name}=\""))?;
        rest.split_once('"').map(|(value, _)| value)
    };
    match (attribute("width"), attribute("height")) {
        (Some(width), Some(height)) if !picture.contains("viewBox") => {
            picture.replacen("<svg ", &format!("<svg viewBox=\"0 0 {width} {height}\" "), 1)
        }
        _ => picture.to_owned(),
    }
}

/// The text written so far, and the equations that wait for the end of their display.
struct Body<'a> {
    typesetter: &'a Typesetter,
    text: String,
    rows: Vec<String>,
    /// Whether the page has its heading.
    titled: bool,
}

impl Body<'_> {
    fn add(&mut self, block: &Block) {
        let question = match block {
            Block::Question(equation) | Block::Truth { equation, .. } => {
                Some(latex::equation(equation))
            }
            Block::QuestionAsTyped(equation) => Some(latex::typed(equation)),
            _ => None,
        };
        if let (Some(question), false) = (question, self.titled) {
            self.titled = true;
            let heading = format!("<h1>{}</h1>\n", self.typesetter.inline(&question));
            self.html(&heading);
            if !matches!(block, Block::Truth { .. }) {
                return;
            }
        }
        match block {
            // With the columns that only text and pages have room for.
            Block::Methods { rows, tolerance, .. } => self.table(&methods(rows, *tolerance)),
            // A heading here, a row of its equations in an article.
            Block::Reading { .. } => {}
            _ => match latex::setting(block) {
                Setting::Table(table) => self.table(&table),
                Setting::Equations(mut rows) => {
                    if let (Some(aside), Some(last)) = (aside(block), rows.last_mut()) {
                        last.push_str(&format!(" \\qquad \\text{{({})}}", latex::words(aside)));
                    }
                    self.rows.extend(rows);
                }
                Setting::Words => {}
            },
        }
        let words = self.words(block);
        if !words.is_empty() {
            self.html(&words);
        }
    }

    /// The words of a block.
    fn words(&self, block: &Block) -> String {
        let paragraph = |words: &str| {
            let set =
                latex::formula_in_words(words).map(|formula| self.typesetter.inline(&formula));
            format!("<p>{}</p>\n", set.unwrap_or_else(|| escaped(words)))
        };
        let heading = |words: &str| format!("<h3>{}</h3>\n", escaped(words));
        match block {
            Block::Title { words, amplitude } => {
                format!(
                    "<h2>{}</h2>\n<p class=\"soft\">{}</p>\n",
                    escaped(words),
                    escaped(amplitude)
                )
            }
            Block::Heading(words) | Block::Reading { words, .. } => heading(words),
            Block::Note(words)
            | Block::Remark(words)
            | Block::Sentence(words)
            | Block::Closing(words) => paragraph(words),
            Block::Detail(words) => paragraph(words.trim_start()),
            Block::Entries { heading: of, entries } => heading(of) + &definitions("long", entries),
            Block::Facts(facts) => definitions("", facts),
            Block::Judged { verification, series_of_omega, hbar } => {
                let (of, facts) = text::judgement(verification, *series_of_omega, *hbar);
                heading(&of) + &definitions("", &facts)
            }
            Block::Truth { at, frequency, .. } => {
                paragraph(&text::comparison::true_frequency(at, frequency))
            }
            Block::Refused(refused) => {
                heading("Not applicable") + &definitions("long", &refusals(refused))
            }
            Block::TrueMotion(lines) => heading("True motion") + &list(lines),
            Block::Motion(solution) => {
                match solution.displacement.is_zero() && solution.closed_motion.is_none() {
                    true => paragraph(text::without_motion(solution)),
                    false => String::new(),
                }
            }
            Block::Quantities { columns, deviations, shapes, .. } => {
                let size = |size: f64| format!("{} %", significant(100.0 * size, 3));
                let of = |(column, (deviation, [approach, contact, back])): (
                    &crate::impact::PhaseReading,
                    (&f64, &[f64; 3]),
                )| {
                    let words = format!(
                        "{} in real time; {} of the approach, {} of the contact, {} of the return, each on its own clock",
                        size(*deviation),
                        size(*approach),
                        size(*contact),
                        size(*back)
                    );
                    (column.name(), words)
                };
                let facts: Vec<(&str, String)> =
                    columns.iter().zip(deviations.iter().zip(shapes)).map(of).collect();
                heading("Largest deviation") + &definitions("", &facts)
            }
            Block::Verdicts { verdicts, tolerance } => {
                let within = significant(100.0 * tolerance, 3);
                let facts = verdicts
                    .iter()
                    .map(|(reading, verdict)| (reading.name(), verdict.name().to_owned()));
                heading(&format!("Verdict: every number and phase within {within} %"))
                    + &definitions("", &facts.collect::<Vec<_>>())
            }
            // Formulas and tables have been set.
            Block::Question(_)
            | Block::QuestionAsTyped(_)
            | Block::Law { .. }
            | Block::Equality { .. }
            | Block::Line(_)
            | Block::Harmonics { .. }
            | Block::CycleAmplitude { .. }
            | Block::Definition(_)
            | Block::Value { .. }
            | Block::Methods { .. }
            | Block::Table { .. }
            | Block::Fitted { .. }
            | Block::Phase { .. }
            | Block::ClosedForms(_)
            | Block::ContactLaws { .. }
            | Block::ImpactMethods { .. }
            | Block::SiValue { .. }
            | Block::SiQuantities { .. } => String::new(),
        }
    }

    fn html(&mut self, html: &str) {
        self.flush();
        self.text.push_str(html);
    }

    fn table(&mut self, table: &LatexTable) {
        let is_number = |cell: &String| {
            let first = cell.trim_start_matches('$').chars().next();
            first.is_none_or(|first| first.is_ascii_digit() || "+-<".contains(first))
        };
        let place = |(column, place): (usize, char)| {
            let numbers = || table.rows.iter().filter_map(|row| row.get(column)).all(is_number);
            match place == 'r' && numbers() {
                true => " class=\"number\"",
                false => "",
            }
        };
        let places: Vec<&str> = table.places.chars().enumerate().map(place).collect();
        let line = |cells: &[String], tag: &str| {
            let cells = cells.iter().zip(&places);
            let cells = cells.map(|(cell, place)| {
                format!("<{tag}{place}>{}</{tag}>", verdict(&self.typesetter.mixed(cell)))
            });
            format!("<tr>{}</tr>\n", cells.collect::<String>())
        };
        let rows: String = table.rows.iter().map(|row| line(row, "td")).collect();
        let head = line(&table.head, "th");
        self.html(&format!(
            "<div class=\"table\"><table>\n<thead>\n{head}</thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n"
        ));
    }

    /// Writes the equations that wait.
    fn flush(&mut self) {
        if !self.rows.is_empty() {
            let rows = std::mem::take(&mut self.rows);
            self.text.push_str(&self.typesetter.display(&rows));
        }
    }
}

/// The remark beside an equation.
fn aside<'a>(block: &Block<'a>) -> Option<&'a str> {
    match block {
        Block::Value { source, .. } => *source,
        Block::SiValue { words, .. } => Some(words),
        _ => None,
    }
}

/// Every method with its numbers and its formula.
fn methods(rows: &[MethodRow], tolerance: f64) -> LatexTable {
    let cells = text::comparison::cells(rows, tolerance);
    let formulas =
        std::iter::once("formula".to_owned()).chain(rows.iter().map(latex::comparison::with_hbar));
    let plain = |cell: String| latex::words(&cell);
    let mut lines: Vec<Vec<String>> = cells
        .into_iter()
        .zip(formulas)
        .map(|(cells, formula)| cells.map(plain).into_iter().chain([formula]).collect())
        .collect();
    let head = lines.remove(0);
    LatexTable { places: "lrrrlrl".to_owned(), head, rows: lines, framed: true }
}

/// Methods that do not apply, those for the same reason together.
fn refusals(refused: &[Refused]) -> Vec<(String, String)> {
    let named = refused.iter().map(|refused| {
        (refused.method.title().to_owned(), refused.reason.without_title(refused.method))
    });
    let grouped = text::comparison::grouped(named);
    grouped.into_iter().map(|(names, reason)| (names.join(", "), reason)).collect()
}

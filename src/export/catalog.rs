//! The catalogue of classical oscillators as text and as LaTeX; as a document it is in
//! `export::json`.

#[cfg(feature = "html")]
use super::html;
use super::latex;
#[cfg(feature = "html")]
use super::latex::LatexTable;
use crate::catalog::{CatalogEntry, methods};

/// A single entry with its equation, its source, the published law and the methods that apply; for
/// several entries a line each with name, equation and title.
///
/// ```
/// use lindstedt::catalog::CATALOG;
/// use lindstedt::export::catalog::text;
///
/// assert!(text(CATALOG).lines().any(|line| line.starts_with("duffing ")));
/// assert!(text(&CATALOG[..1]).contains("published: "));
/// ```
pub fn text(entries: &[CatalogEntry]) -> String {
    if let [entry] = entries {
        return entry_as_text(entry);
    }
    let width = |text: fn(&CatalogEntry) -> &str| {
        entries.iter().map(|entry| text(entry).chars().count()).max().unwrap_or(0)
    };
    // Several equations are longer than the column of one.
    let of_one = |entry: &CatalogEntry| if entry.is_coupled() { "" } else { entry.equation };
    let (name, equation) = (width(|entry| entry.name), width(of_one));
    let line = |entry: &CatalogEntry| {
        format!("{:name$}  {:equation$}  {}\n", entry.name, entry.equation, entry.title)
    };
    entries.iter().map(line).collect()
}

/// Each entry as an item of a list: its equation and the published law.
///
/// ```
/// use lindstedt::catalog::CATALOG;
/// assert!(lindstedt::export::catalog::latex(CATALOG).contains(r"\item[duffing]"));
/// ```
pub fn latex(entries: &[CatalogEntry]) -> String {
    let items: Vec<String> = entries.iter().map(item).collect();
    format!("\\begin{{description}}\n{}\n\\end{{description}}\n", items.join("\n"))
}

/// The entries as a page: one as its text, several as a table of names, equations and titles.
///
/// ```
/// use lindstedt::catalog::CATALOG;
/// use lindstedt::export::{catalog::html, html::HtmlPage};
/// assert!(html(CATALOG, &HtmlPage::default()).contains("<td>duffing</td><td><math"));
/// ```
#[cfg(feature = "html")]
pub fn html(entries: &[CatalogEntry], page: &html::HtmlPage) -> String {
    if let [entry] = entries {
        return html::lines(&entry_as_text(entry), page);
    }
    let row = |entry: &CatalogEntry| {
        let equation = format!("${}$", latex::typed(entry.equation));
        vec![entry.name.to_owned(), equation, entry.title.to_owned()]
    };
    let table = LatexTable {
        places: "lll".to_owned(),
        head: ["name", "equation", "title"].map(str::to_owned).to_vec(),
        rows: entries.iter().map(row).collect(),
        framed: false,
    };
    html::table(&table, page)
}

fn entry_as_text(entry: &CatalogEntry) -> String {
    let mut lines =
        vec![format!("{}: {}", entry.name, entry.title), format!("  {}", entry.equation)];
    lines.extend(entry.walls.iter().map(|bound| format!("  wall {bound}, restitution e")));
    lines.push(format!("  {}", entry.source));
    lines.extend(entry.published.map(|law| format!("  published: {law}")));
    let (mut applying, mut refused): (Vec<&str>, Vec<(String, Vec<&str>)>) = (vec![], vec![]);
    for (method, result) in methods(entry) {
        let Err(reason) = result else {
            applying.push(method.name());
            continue;
        };
        match refused.iter_mut().find(|known| known.0 == reason) {
            Some(known) => known.1.push(method.name()),
            None => refused.push((reason, vec![method.name()])),
        }
    }
    lines.extend(wrapped("  by ", &applying, ""));
    for (reason, names) in refused {
        lines.extend(wrapped("  not by ", &names, &format!(": {reason}")));
    }
    lines.join("\n") + "\n"
}

/// Names after a beginning, broken into lines of about a hundred characters, and an end.
fn wrapped(start: &str, names: &[&str], end: &str) -> Vec<String> {
    const WIDTH: usize = 100;
    let mut lines = vec![start.to_owned()];
    for (index, name) in names.iter().enumerate() {
        let separator = if index + 1 < names.len() { ", " } else { end };
        let full = lines.last().is_some_and(|line| line.len() + name.len() > WIDTH);
        if full {
            lines.push("    ".to_owned());
        }
        if let Some(line) = lines.last_mut() {
            line.push_str(name);
            line.push_str(separator);
        }
    }
    if names.is_empty() {
        vec![]
    } else {
        lines.iter().map(|line| line.trim_end().to_owned()).collect()
    }
}

/// Equation and published law; titles and sources contain no LaTeX commands.
fn item(entry: &CatalogEntry) -> String {
    let law = entry.published.map(|law| {
        let law = law.to_string();
        format!(", published $ {} $", latex::typed(law.trim_end_matches(" + ...")))
    });
    let (equation, law) = (latex::typed(entry.equation), law.unwrap_or_default());
    format!("\\item[{}] {}: $ {equation} ${law}", entry.name, entry.title)
}

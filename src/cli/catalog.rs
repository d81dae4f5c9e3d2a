//! `lindstedt catalog`.

use clap::Args;
use lindstedt::catalog::{CATALOG, Entry, methods};
use lindstedt::export::latex;
use serde_json::{Value, json};

use super::{Common, Failure, Format, Outcome, json_text};

#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    pub common: Common,
}

pub fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if arguments.common.plot.is_some() {
        return Err(Failure::Usage("--plot: the catalogue has no picture".to_owned()));
    }
    let text = match arguments.common.format {
        Format::Text => CATALOG.iter().map(text).collect::<Vec<_>>().join("\n"),
        Format::Latex => {
            let items: Vec<String> = CATALOG.iter().map(item).collect();
            format!("\\begin{{description}}\n{}\n\\end{{description}}\n", items.join("\n"))
        }
        Format::Csv => return super::no_table(),
        Format::Json => {
            let entries: Vec<Value> = CATALOG.iter().map(document).collect();
            json_text(&json!({ "schema": "lindstedt/catalog/1", "entries": entries }))
        }
    };
    Ok(Outcome {
        text,
        picture: None,
        note: None,
        verdict: None,
    })
}

fn published(entry: &Entry) -> Option<String> {
    let published = entry.published?;
    Some(format!(
        "{} = {} + ...",
        if published.squared { "omega^2" } else { "omega" },
        published.law
    ))
}

fn text(entry: &Entry) -> String {
    let mut lines = vec![
        format!("{}: {}", entry.name, entry.title),
        format!("  {}", entry.equation),
        format!("  {}", entry.source),
    ];
    lines.extend(published(entry).map(|law| format!("  published: {law}")));
    for (method, result) in methods(entry) {
        lines.push(match result {
            Ok(()) => format!("  {}", method.name()),
            Err(refusal) => format!("  not {}: {refusal}", method.name()),
        });
    }
    lines.join("\n") + "\n"
}

/// Equation and published law; titles and sources hold nothing that LaTeX reads as a command.
fn item(entry: &Entry) -> String {
    let law =
        published(entry).map(|law| format!(", published $ {} $", latex::equation(law.trim_end_matches(" + ..."))));
    let (equation, law) = (latex::equation(entry.equation), law.unwrap_or_default());
    format!("\\item[{}] {}: $ {equation} ${law}", entry.name, entry.title)
}

fn document(entry: &Entry) -> Value {
    let method = |(method, result): (lindstedt::solution::Method, Result<(), _>)| {
        let reason = result
            .err()
            .map(|refusal: lindstedt::method::Refusal| refusal.to_string());
        json!({ "method": method.name(), "applies": reason.is_none(), "reason": reason })
    };
    json!({
        "name": entry.name,
        "title": entry.title,
        "equation": entry.equation,
        "source": entry.source,
        "published": published(entry),
        "methods": methods(entry).into_iter().map(method).collect::<Vec<_>>(),
    })
}

//! `lindstedt catalog`.

use crate::catalog::{CATALOG, find, nearest};
use crate::export::text::fitted;
use crate::export::{catalog, json};
use clap::Args;

use super::answer::{no_such, page};
use super::files::{OF_FILES, width};
use super::{Common, Failure, Format, Outcome, Work, json_text, text_writer};

/// List the classical oscillators that `derive` knows by name
#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
pub struct CatalogArguments {
    /// One of them, with its source, its published law and what each method says to it; without it
    /// a line for each
    name: Option<String>,
    #[command(flatten)]
    pub common: Common,
}

impl Work for CatalogArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &CatalogArguments) -> Result<Outcome, Failure> {
    if arguments.common.plot.is_some() {
        return Err(Failure::Usage("--plot: the catalogue has no picture".to_owned()));
    }
    if arguments.common.tolerance.is_some() {
        return Err(Failure::Usage("--tolerance: the catalogue has no verdict".to_owned()));
    }
    let entries = match &arguments.name {
        None => CATALOG,
        Some(name) => std::slice::from_ref(find(name).ok_or_else(|| {
            let near = nearest(name, CATALOG.iter().map(|entry| entry.name));
            let help = near.map_or_else(
                || "`lindstedt catalog` lists the names".to_owned(),
                |near| format!("did you mean `{near}`?"),
            );
            Failure::Usage(format!("the catalogue has no `{name}`\n  help: {help}"))
        })?),
    };
    let width = width(arguments.common.output.as_deref());
    let text = match arguments.common.format() {
        // A line for each, however long, but in a narrow terminal.
        Format::Text if arguments.name.is_none() && width >= OF_FILES => catalog::text(entries),
        Format::Text => fitted(&catalog::text(entries), width),
        Format::Latex => arguments.common.latex(catalog::latex(entries)),
        Format::Html => page(None, None, |page| catalog::html(entries, page)),
        Format::Json => json_text(&json::catalog(entries))?,
        format => no_such(format)?,
    };
    Ok(Outcome {
        result: text_writer(text),
        picture: None,
        note: None,
        verdict: None,
        partial: false,
    })
}

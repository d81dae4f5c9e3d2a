//! `lindstedt schema KIND`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use lindstedt::export::json::DocumentKind;

use super::{Common, Failure, Outcome, Work, text_writer};

/// Print the JSON Schema of a kind of document: every key with its meaning and unit
#[derive(Args)]
pub struct SchemaArguments {
    /// The kind of document, the middle of what stands under its `schema`
    #[arg(value_parser = PossibleValuesParser::new(DocumentKind::ALL.map(DocumentKind::name)).try_map(|name| DocumentKind::from_name(&name).ok_or("no kind")))]
    kind: DocumentKind,
    /// Write the schema to this file instead of standard output; - for standard output
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
}

impl Work for SchemaArguments {
    /// The place of the schema, which has no other format and no verdict.
    fn common(&self) -> Common {
        Common { output: self.output.clone(), ..Common::default() }
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &SchemaArguments) -> Result<Outcome, Failure> {
    Ok(Outcome {
        result: text_writer(arguments.kind.json_schema().to_owned()),
        picture: None,
        note: None,
        verdict: None,
        partial: false,
    })
}

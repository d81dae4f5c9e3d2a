//! `lindstedt schema KIND`.

use std::path::PathBuf;

use crate::export::json::DocumentKind;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::{Common, Failure, Outcome, Work, text_writer};

/// Print the JSON Schema of a kind of document: every key with its meaning and unit
#[derive(Args)]
pub struct SchemaArguments {
    /// The kind of document, the middle of what stands under its `schema`, or the command that
    /// writes it
    #[arg(value_parser = kind())]
    kind: DocumentKind,
    /// Write the schema to this file instead of standard output; - for standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Reads the name of a kind, or of the command that writes it.
fn kind() -> impl TypedValueParser<Value = DocumentKind> {
    const OF_COMMANDS: [(&str, DocumentKind); 7] = [
        ("derive", DocumentKind::Solution),
        ("compare", DocumentKind::Comparison),
        ("simulate", DocumentKind::Simulation),
        ("lagrange", DocumentKind::Lagrangian),
        ("optimize", DocumentKind::Optimization),
        ("paper", DocumentKind::Audit),
        ("certify", DocumentKind::Certificate),
    ];
    let commands =
        move |kind: DocumentKind| OF_COMMANDS.into_iter().filter(move |(_, of)| *of == kind);
    let value = move |kind: DocumentKind| {
        PossibleValue::new(kind.name()).aliases(commands(kind).map(|(command, _)| command))
    };
    PossibleValuesParser::new(DocumentKind::ALL.map(value)).try_map(|name| {
        let written = OF_COMMANDS.into_iter().find(|(command, _)| *command == name);
        let kind = written.map(|(_, kind)| kind).or_else(|| DocumentKind::from_name(&name));
        kind.ok_or("no kind of this name")
    })
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

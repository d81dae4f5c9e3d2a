//! `lindstedt schema KIND`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use lindstedt::export::json::Kind;

use super::{Common, Failure, Outcome, Work, text_writer};

/// Print the JSON Schema of a kind of document: every key with its meaning and unit
#[derive(Args)]
pub struct Arguments {
    /// The kind of document, the middle of what stands under its `schema`, or the command that
    /// writes it
    #[arg(value_parser = kind())]
    kind: Kind,
    /// Write the schema to this file instead of standard output; - for standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Reads the name of a kind, or of the command that writes it.
fn kind() -> impl TypedValueParser<Value = Kind> {
    const OF_COMMANDS: [(&str, Kind); 7] = [
        ("derive", Kind::Solution),
        ("compare", Kind::Comparison),
        ("simulate", Kind::Simulation),
        ("lagrange", Kind::Lagrangian),
        ("optimize", Kind::Optimization),
        ("paper", Kind::Audit),
        ("certify", Kind::Certificate),
    ];
    let commands = move |kind: Kind| OF_COMMANDS.into_iter().filter(move |(_, of)| *of == kind);
    let value = move |kind: Kind| {
        PossibleValue::new(kind.name()).aliases(commands(kind).map(|(command, _)| command))
    };
    PossibleValuesParser::new(Kind::ALL.map(value)).try_map(|name| {
        let written = OF_COMMANDS.into_iter().find(|(command, _)| *command == name);
        let kind = written.map(|(_, kind)| kind).or_else(|| Kind::from_name(&name));
        kind.ok_or("no kind of this name")
    })
}

impl Work for Arguments {
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

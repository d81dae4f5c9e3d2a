//! `lindstedt schema KIND`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use lindstedt::export::json::Kind;

use super::{Common, Failure, Outcome, whole};

#[derive(Args)]
pub struct Arguments {
    /// The kind of document, the middle of what stands under its `schema`
    #[arg(value_parser = PossibleValuesParser::new(Kind::ALL.map(Kind::name)).try_map(|name| Kind::from_name(&name).ok_or("no kind")))]
    kind: Kind,
    /// Write the schema to this file instead of standard output; - for standard output
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
}

impl Arguments {
    /// Where the schema goes; it has no other format and no verdict.
    pub fn common(&self) -> Common {
        Common {
            output: self.output.clone(),
            ..Common::default()
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    Ok(Outcome {
        result: whole(arguments.kind.json_schema().to_owned()),
        picture: None,
        note: None,
        verdict: None,
        partial: false,
    })
}

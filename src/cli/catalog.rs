//! `lindstedt catalog`.

use clap::Args;
use lindstedt::export::{catalog, json};

use super::{Common, Failure, Format, Outcome, json_text, whole};

#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
#[command(mut_arg("format", super::without_table))]
pub struct Arguments {
    #[command(flatten)]
    pub common: Common,
}

pub fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if arguments.common.plot.is_some() {
        return Err(Failure::Usage("--plot: the catalogue has no picture".to_owned()));
    }
    if arguments.common.tolerance.is_some() {
        return Err(Failure::Usage("--tolerance: the catalogue has no verdict".to_owned()));
    }
    let text = match arguments.common.format {
        Format::Text => catalog::text(),
        Format::Latex => catalog::latex(),
        Format::Csv => return super::no_table(),
        Format::Json => json_text(&json::catalog())?,
        Format::Code(language) => super::no_program(language)?,
    };
    Ok(Outcome {
        result: whole(text),
        picture: None,
        note: None,
        verdict: None,
        partial: false,
    })
}

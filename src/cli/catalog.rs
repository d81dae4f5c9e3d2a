//! `lindstedt catalog`.

use clap::Args;
use lindstedt::export::{catalog, html, json};

use super::answer::{no_such, page};
use super::{Common, Failure, Format, Outcome, Work, json_text, whole};

/// List the classical oscillators that `derive` knows by name
#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
pub struct Arguments {
    #[command(flatten)]
    pub common: Common,
}

impl Work for Arguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if arguments.common.plot.is_some() {
        return Err(Failure::Usage("--plot: the catalogue has no picture".to_owned()));
    }
    if arguments.common.tolerance.is_some() {
        return Err(Failure::Usage("--tolerance: the catalogue has no verdict".to_owned()));
    }
    let text = match arguments.common.format() {
        Format::Text => catalog::text(),
        Format::Latex => catalog::latex(),
        Format::Html => page(None, None, |page| html::lines(&catalog::text(), page)),
        Format::Json => json_text(&json::catalog())?,
        format => no_such(format)?,
    };
    Ok(Outcome { result: whole(text), picture: None, note: None, verdict: None, partial: false })
}

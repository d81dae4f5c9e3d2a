//! `lindstedt friction`.

use clap::Args;
use lindstedt::export::{friction, json, latex, text};
use lindstedt::impact::friction::{FrictionSetup, FrictionStudy, study};

use super::{Common, Failure, Format, Outcome, json_text, whole};

#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
pub struct Arguments {
    /// The friction alpha, between 0 and 1; 0.05 without it, for the paper prints none
    #[arg(long, value_name = "ALPHA", allow_hyphen_values = true)]
    alpha: Option<f64>,
    /// The swing is released from rest at x = -A; 1.5 without it, as in the paper
    #[arg(long, value_name = "A", allow_hyphen_values = true)]
    amplitude: Option<f64>,
    /// Compare the two laws at this speed too, in units of omega (repeatable)
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    speed: Vec<f64>,
    #[command(flatten)]
    pub common: Common,
}

pub fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if arguments.common.tolerance.is_some() {
        return Err(Failure::Usage(
            "--tolerance: a study of friction compares two laws and has no verdict".to_owned(),
        ));
    }
    let usual = FrictionSetup::default();
    let setup = FrictionSetup {
        alpha: arguments.alpha.unwrap_or(usual.alpha),
        amplitude: arguments.amplitude.unwrap_or(usual.amplitude),
        speeds: arguments.speed.clone(),
    };
    let study = study(setup).map_err(|error| Failure::refused(&error, None))?;
    let text = match arguments.common.format {
        Format::Text => text::friction(&study),
        Format::Latex => latex::friction(&study),
        Format::Csv => friction::csv(&study),
        Format::Json => json_text(&json::friction(&study))?,
        Format::Code(language) => super::no_program(language)?,
    };
    let picture = arguments
        .common
        .plot
        .as_ref()
        .map(|path| (path.clone(), picture(&study)));
    Ok(Outcome {
        result: whole(text),
        picture,
        note: None,
        verdict: None,
        partial: false,
    })
}

#[cfg(not(feature = "plot"))]
fn picture(_: &FrictionStudy) -> Result<String, Failure> {
    super::no_pictures()
}

#[cfg(feature = "plot")]
fn picture(study: &FrictionStudy) -> Result<String, Failure> {
    friction::picture(study).map_err(|error| Failure::refused(&error, None))
}

//! `lindstedt friction`.

use crate::export::{friction, json};
use crate::impact::friction::{FrictionSetup, study};
use crate::report;
use clap::Args;

use super::answer::{Answer, no_such};
use super::files::width;
use super::{Common, Failure, Format, Outcome, Work, json_text};

/// The arctangent in place of Coulomb's sgn: the paper's Table 1, and what it does to a swing near
/// rest
#[derive(Args)]
#[command(mut_arg("tolerance", super::no_verdict))]
pub struct FrictionArguments {
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

impl Work for FrictionArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &FrictionArguments) -> Result<Outcome, Failure> {
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
    let study = study(setup)?;
    let answer = Answer {
        document: &report::friction(&study),
        width: width(arguments.common.output.as_deref()),
        picture: Some(&|| Ok(friction::picture(&study)?)),
        other: &|format| match format {
            Format::Csv => Ok(friction::csv(&study)),
            Format::Json => json_text(&json::friction(&study)),
            format => no_such(format),
        },
    };
    answer.outcome(&arguments.common)
}

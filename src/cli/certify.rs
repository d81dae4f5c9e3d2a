//! `lindstedt certify PROBLEM` and `lindstedt check FILE`.

use std::path::{Path, PathBuf};

use crate::certificate::{
    self, Certified, DampedCertificate, LawCertificate, LawError, NotCertified, RangeEnd,
};
use crate::coupled::CoupledEquations;
use crate::exact::Rational;
use crate::export::json::{
    self, CertificateDocument, CoupledCertificateDocument, DampedCertificateDocument,
    LawCertificateDocument, ModeCertificateDocument, OrbitCertificateDocument,
};
use crate::export::printable_in_line;
use crate::expr::{ExprError, parse_expression};
use crate::method::with_resonance_at;
use crate::problem::{Problem, ReadingCommand};
use crate::report::{
    self, AnyCertificate, CertificateReport, CertifiedQuestion, OrbitCertificateReport,
};
use crate::verify::Verdict;
use crate::{Method, Options, Oscillator, Solution, Symbol, Values, solve};
use clap::Args;
use num_traits::Signed as _;

use super::answer::{Answer, no_such};
use super::derive::{self, EquationArguments, Solved, exact_values};
use super::files::width;
use super::modes::{self, Derived};
use super::problem::coupled_equations;
use super::progress::with_progress;
use super::session;
use super::{Common, Failure, Format, Outcome, Work, json_text, read_at_most, tolerance};

/// A proof beside a formula: the motion exists, and how far the formula is off, from both sides
#[derive(Args)]
#[command(mut_arg("plot", |plot| plot.hide(true)))]
#[command(mut_arg("output", |output| output.help("Write the result to this file; if its name ends in .json, the certificate that `check` reads, or of a range its numbers")))]
pub struct CertifyArguments {
    #[command(flatten)]
    pub question: EquationArguments,
    /// Positive amplitudes, 1/10:3 say: how far from the first of them on the formula is proved to
    /// be within the tolerance, for every amplitude
    #[arg(long, value_name = "LOW:HIGH", value_parser = range)]
    range: Option<(Rational, Rational)>,
    /// Prove the motion alone, and judge no formula: where that has no real value, say
    #[arg(long, conflicts_with = "range")]
    no_formula: bool,
    /// Which normal mode of coupled equations, 1 for the slowest and without this
    #[arg(long, value_name = "N", value_parser = super::count, allow_hyphen_values = true)]
    mode: Option<u32>,
    #[command(flatten)]
    pub common: Common,
}

/// Check a certificate that `certify` wrote, in exact arithmetic
#[derive(Args)]
#[command(mut_arg("plot", |plot| plot.hide(true)))]
#[command(mut_arg("timeout", |timeout| timeout.help("Give up after so many seconds, 60 without it: a certificate may come from anybody")))]
pub struct CheckArguments {
    /// A certificate, as `certify` writes it; - for standard input
    pub file: PathBuf,
    #[command(flatten)]
    pub common: Common,
}

/// The time limit of `check` in seconds where none is given.
pub const LONGEST_CHECK: f64 = 60.0;

/// A certificate of the most harmonics has this many bytes.
const LARGEST_CERTIFICATE: usize = 16 << 20;

/// Two positive numbers, the smaller one first.
fn range(text: &str) -> Result<(Rational, Rational), String> {
    let end = |text: &str| parse_expression(text).ok().and_then(|value| value.as_number().cloned());
    let ends = text.split_once(':').and_then(|(low, high)| end(low).zip(end(high)));
    ends.filter(|(low, high)| low.is_positive() && low < high).ok_or_else(|| {
        "expected two positive fractions or decimals, the smaller one first, such as 1/10:3"
            .to_owned()
    })
}

impl Work for CertifyArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn input(&self) -> Option<&Path> {
        super::problem::path(&self.question.problem)
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &CertifyArguments) -> Result<Outcome, Failure> {
    without_picture(&arguments.common)?;
    let problem = arguments.question.problem()?;
    if let Some(equations) = coupled_equations(&problem, ReadingCommand::Derive)? {
        let driven = equations.rates.right.iter().any(|rate| rate.contains(Symbol::new("t")));
        let is_one = driven || is_of_cycle(arguments, &equations, &problem)?;
        return match is_one {
            true => certified_coupled(arguments, &equations, &problem),
            false => certified_mode(arguments, equations, &problem),
        };
    }
    if arguments.mode.is_some() {
        return Err(Failure::Usage(
            "--mode: one coordinate has one mode; the modes of coupled equations are numbered"
                .to_owned(),
        ));
    }
    derive::with_motion(&arguments.question, &[("a certificate", true)])?;
    let Solved { oscillator, values, solution, letters } =
        derive::solved_problem(&arguments.question, &problem)?;
    let _letters = letters.in_force();
    let values = values.unwrap_or_default();
    // A proof of a driven motion is of the steady one alone, whose formula is that of slow
    // equations.
    let solution = match solution.in_time() {
        Some(_) => steady_formula(&oscillator, &values).unwrap_or(solution),
        None => solution,
    };
    derive::check_values(&solution, &values)?;
    let refused = |error: &NotCertified| Failure::refused(error, error.help());
    let tolerance = tolerance(&arguments.common);
    let question = (&solution, &values);
    if solution.limit_cycle.is_some() {
        let proved = || match arguments.no_formula {
            true => certificate::certify_cycle_motion(&oscillator, &solution, &values),
            false => certificate::certify_cycle(&oscillator, &solution, &values),
        };
        return without_amplitude(arguments, question, "a limit cycle", proved);
    }
    if solution.response.is_some() {
        if arguments.no_formula {
            return Err(Failure::because(
                "--no-formula leaves nothing to find a driven motion by: of several it is the one near the formula's\n  help: leave --no-formula out; `response` finds the motions of a range in numbers".to_owned(),
            ));
        }
        let proved = || certificate::certify_driven(&oscillator, &solution, &values);
        return without_amplitude(arguments, question, "a driven motion", proved);
    }
    let proved = match arguments.no_formula {
        true => certificate::certify_motion(&oscillator, &solution, &values),
        false => certificate::certify(&oscillator, &solution, &values),
    };
    let (certificate, certified) = proved.map_err(|error| refused(&error))?;
    let supervision = session::supervision();
    let validity = arguments.range.as_ref().map(|(low, high)| {
        with_progress("of the range", || {
            certificate::validity(
                &oscillator,
                &solution,
                &values,
                [low, high],
                tolerance,
                supervision,
            )
        })
    });
    let validity = validity.transpose().map_err(|error| refused(&error))?;
    let report = CertificateReport {
        question: Some(CertifiedQuestion::Formula(&solution, &values)),
        certificate: (&certificate).into(),
        certified: &certified,
        validity: validity.as_ref(),
        tolerance,
    };
    let outcome = printed(&report, &arguments.common)?;
    let partial = validity.is_some_and(|validity| validity.beyond == RangeEnd::Stopped);
    Ok(Outcome { partial, ..outcome })
}

/// The proof of the motion of a normal mode.
fn certified_mode(
    arguments: &CertifyArguments,
    equations: CoupledEquations,
    problem: &Problem,
) -> Result<Outcome, Failure> {
    arguments.question.check_of_modes()?;
    if arguments.range.is_some() {
        return Err(Failure::Usage(
            "--range: it is of one coordinate; of a mode each amplitude is proved by itself"
                .to_owned(),
        ));
    }
    let method = arguments.question.method.as_deref().or(problem.method.as_deref());
    if let Some(name) = method.filter(|name| *name != Method::LindstedtPoincare.name()) {
        return Err(Failure::Usage(format!(
            "--method {name}: what is proved of a mode is its series by {}, which is meant without --method",
            Method::LindstedtPoincare.name()
        )));
    }
    let Derived { modes, values, letters } =
        modes::derived(&arguments.question, arguments.mode.or(Some(1)), false, equations, problem)?;
    let _letters = letters.in_force();
    let Some(Ok(mode)) = modes.modes.first() else {
        return Err(Failure::because("there is no such mode".to_owned()));
    };
    let values = values.unwrap_or_default();
    let proved = match arguments.no_formula {
        true => certificate::certify_mode_motion(&modes.system, mode, &values),
        false => certificate::certify_mode(&modes.system, mode, &values),
    };
    let (certificate, certified) = proved.map_err(|error| match &error {
        NotCertified::Truth(error) => derive::unjudged(error),
        error => Failure::refused(error, error.help()),
    })?;
    let report = CertificateReport {
        question: Some(CertifiedQuestion::Mode(&modes, &values)),
        certificate: (&certificate).into(),
        certified: &certified,
        validity: None,
        tolerance: tolerance(&arguments.common),
    };
    printed(&report, &arguments.common)
}

/// Whether a limit cycle of coupled equations without a drive is asked for: they have damping, and
/// neither a mode nor an amplitude is given.
fn is_of_cycle(
    arguments: &CertifyArguments,
    equations: &CoupledEquations,
    problem: &Problem,
) -> Result<bool, Failure> {
    let values = exact_values(&arguments.question.at, problem.values_of_motion())?;
    let is_own = |name: Symbol| {
        equations.parameters.contains(&name) || equations.coordinates.contains(&name)
    };
    let has_others = values.iter().flat_map(Values::iter).any(|(name, _)| !is_own(name));
    let refused = |error| Failure::because(format!("{error}"));
    Ok(arguments.mode.is_none()
        && !has_others
        && equations.has_damping().map_err(|error: ExprError| refused(error))?)
}

/// The proof of a steady motion of driven coordinates, that to which the motion from rest comes, or
/// of a limit cycle of several coordinates.
fn certified_coupled(
    arguments: &CertifyArguments,
    equations: &CoupledEquations,
    problem: &Problem,
) -> Result<Outcome, Failure> {
    let question = &arguments.question;
    let given = [
        ("--mode", arguments.mode.is_some()),
        ("--range", arguments.range.is_some()),
        ("--method", question.method.is_some()),
        ("--order", question.order.is_some()),
        ("--amplitude", question.amplitude.is_some()),
        ("--small", question.small.is_some()),
        ("--resonance", question.resonance.is_some()),
    ];
    let given = given.into_iter().find(|(_, given)| *given).map(|(option, _)| option);
    if let Some(option) = given.or(question.of_one_coordinate()) {
        return Err(Failure::Usage(format!(
            "{option}: of several driven or self-excited coordinates the motion alone is proved, without a formula; values are given by --at"
        )));
    }
    let values = exact_values(&question.at, problem.values_of_motion())?.unwrap_or_default();
    let (certificate, certified) =
        with_progress("of this proof", || certificate::certify_coupled(equations, &values))
            .map_err(|error| Failure::refused(&error, error.help()))?;
    let report = CertificateReport {
        question: Some(CertifiedQuestion::FromRest(&values)),
        certificate: (&certificate).into(),
        certified: &certified,
        validity: None,
        tolerance: tolerance(&arguments.common),
    };
    printed(&report, &arguments.common)
}

/// The formula of the steady motion under a drive; `None` if there is none.
fn steady_formula(oscillator: &Oscillator, values: &Values) -> Option<Solution> {
    let options = Options { method: Some(Method::MultipleScales), ..Options::default() };
    let options = with_resonance_at(oscillator, &options, values).ok()?;
    solve(oscillator, &options).ok()
}

/// The proof of a motion that has an amplitude of its own.
fn without_amplitude(
    arguments: &CertifyArguments,
    (solution, values): (&Solution, &Values),
    kind: &str,
    proved: impl FnOnce() -> Result<(DampedCertificate, Certified), NotCertified>,
) -> Result<Outcome, Failure> {
    if arguments.range.is_some() {
        return Err(Failure::because(format!(
            "--range is of amplitudes, and {kind} has one of its own\n  help: leave --range out: the proof is of the motion at these values"
        )));
    }
    let (certificate, certified) =
        proved().map_err(|error| Failure::refused(&error, error.help()))?;
    let report = CertificateReport {
        question: Some(CertifiedQuestion::Formula(solution, values)),
        certificate: (&certificate).into(),
        certified: &certified,
        validity: None,
        tolerance: tolerance(&arguments.common),
    };
    printed(&report, &arguments.common)
}

impl Work for CheckArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn input(&self) -> Option<&Path> {
        Some(&self.file)
    }

    fn run(&self) -> Result<Outcome, Failure> {
        check(self)
    }
}

fn check(arguments: &CheckArguments) -> Result<Outcome, Failure> {
    without_picture(&arguments.common)?;
    let file = &arguments.file;
    let refused = |reason: &dyn std::fmt::Display| {
        let reason = printable_in_line(&reason.to_string());
        Failure::because(format!("{}: {reason}", file.display()))
    };
    let text = read_at_most(file, LARGEST_CERTIFICATE)?;
    let unread = |error: &dyn std::fmt::Display| refused(&format!("no certificate: {error}"));
    // The kind of certificate is read first, and then the rest.
    let EquationAlone { ode } = serde_json::from_str(&text).map_err(|error| unread(&error))?;
    if json::EQUATIONS_ON_A_RANGE.contains(&ode.as_str()) {
        let document: LawCertificateDocument =
            serde_json::from_str(&text).map_err(|error| unread(&error))?;
        let law = document.read().map_err(|error| unread(&error))?;
        let error = certificate::check_law(&law).map_err(|error| refused(&error))?;
        return law_printed(&law, &error, &arguments.common);
    }
    if ode == json::EQUATION_WITH_WALLS {
        let document: OrbitCertificateDocument =
            serde_json::from_str(&text).map_err(|error| unread(&error))?;
        let orbits = document.read().map_err(|error| unread(&error))?;
        let proved = certificate::check_orbits(&orbits).map_err(|error| refused(&error))?;
        let report = OrbitCertificateReport {
            certificate: &orbits,
            proved: proved.iter().collect(),
            not_proved: vec![],
            not_followed: 0,
        };
        return orbits_printed(&report, &arguments.common);
    }
    let tolerance = tolerance(&arguments.common);
    let (motion, damped, mode, coupled);
    let of_damped = [json::EQUATION_OF_CYCLES, json::EQUATION_WITH_DRIVE];
    let of_coupled = [json::EQUATIONS_OF_CYCLES, json::EQUATIONS_WITH_DRIVE];
    let (certificate, certified): (AnyCertificate, _) = if of_damped.contains(&ode.as_str()) {
        let document: DampedCertificateDocument =
            serde_json::from_str(&text).map_err(|error| unread(&error))?;
        damped = document.read().map_err(|error| unread(&error))?;
        ((&damped).into(), certificate::check_damped(&damped))
    } else if ode == json::EQUATIONS_OF_MODES {
        let document: ModeCertificateDocument =
            serde_json::from_str(&text).map_err(|error| unread(&error))?;
        mode = document.read().map_err(|error| unread(&error))?;
        ((&mode).into(), certificate::check_mode(&mode))
    } else if of_coupled.contains(&ode.as_str()) {
        let document: CoupledCertificateDocument =
            serde_json::from_str(&text).map_err(|error| unread(&error))?;
        coupled = document.read().map_err(|error| unread(&error))?;
        ((&coupled).into(), certificate::check_coupled(&coupled))
    } else {
        let document: CertificateDocument =
            serde_json::from_str(&text).map_err(|error| unread(&error))?;
        motion = document.read().map_err(|error| unread(&error))?;
        ((&motion).into(), certificate::check(&motion))
    };
    let report = CertificateReport {
        question: None,
        certificate,
        certified: &certified.map_err(|error| refused(&error))?,
        validity: None,
        tolerance,
    };
    printed(&report, &arguments.common)
}

/// The key of a certificate that says of which kind it is.
#[derive(serde::Deserialize)]
struct EquationAlone {
    ode: String,
}

/// Refuses a picture, before any work is done for it.
pub(super) fn without_picture(common: &Common) -> Result<(), Failure> {
    match common.plot {
        None => Ok(()),
        Some(_) => Err(Failure::because(
            "a proof has no picture\n  help: `derive` draws the formula beside the true motion"
                .to_owned(),
        )),
    }
}

/// The answer to a certificate of a law on a range, with a verdict on its largest error.
fn law_printed(
    law: &LawCertificate,
    error: &LawError,
    common: &Common,
) -> Result<Outcome, Failure> {
    let answer = Answer {
        document: &report::law_certificate(law, error),
        width: width(common.output.as_deref()),
        picture: None,
        other: &|format| match format {
            Format::Json => json_text(&json::law_certificate(law)),
            format => no_such(format),
        },
    };
    let is_within = common.tolerance.is_none_or(|tolerance| error.upper <= tolerance);
    Ok(Outcome { verdict: Some(Verdict::from_passed(is_within)), ..answer.outcome(common)? })
}

/// The answer to a certificate of impact orbits; it passes if every orbit that a motion follows is proved.
pub(super) fn orbits_printed(
    report: &OrbitCertificateReport,
    common: &Common,
) -> Result<Outcome, Failure> {
    let document =
        report::orbit_certificate(report).map_err(|error| Failure::because(error.to_string()))?;
    let answer = Answer {
        document: &document,
        width: width(common.output.as_deref()),
        picture: None,
        other: &|format| match format {
            Format::Json => json_text(&json::orbit_certificate(report.certificate)),
            format => no_such(format),
        },
    };
    let is_proved = report.not_proved.is_empty();
    Ok(Outcome { verdict: Some(Verdict::from_passed(is_proved)), ..answer.outcome(common)? })
}

fn printed(report: &CertificateReport, common: &Common) -> Result<Outcome, Failure> {
    let answer = Answer {
        document: &report::certificate(report),
        width: width(common.output.as_deref()),
        picture: None,
        other: &|format| match format {
            Format::Json => match (json::certificate_range(report), report.certificate) {
                (Some(range), _) => json_text(&range),
                (None, AnyCertificate::Motion(certificate)) => {
                    json_text(&json::certificate(certificate))
                }
                (None, AnyCertificate::Damped(certificate)) => {
                    json_text(&json::damped_certificate(certificate))
                }
                (None, AnyCertificate::Mode(certificate)) => {
                    json_text(&json::mode_certificate(certificate))
                }
                (None, AnyCertificate::Coupled(certificate)) => {
                    json_text(&json::coupled_certificate(certificate))
                }
            },
            format => no_such(format),
        },
    };
    Ok(Outcome { verdict: report.verdict().or(Some(Verdict::Pass)), ..answer.outcome(common)? })
}

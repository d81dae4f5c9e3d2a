//! `lindstedt impact [FILE]`.

use std::collections::BTreeMap;
use std::path::Path;

use crate::Symbol;
use crate::certificate::{PowerLaw, enclose_dashpot_impact, enclose_impact, enclose_lossy_impact};
use crate::exact::Rational;
use crate::export::json;
use crate::expr::{Expr, parse_expression};
use crate::impact::contact::Dashpot;
use crate::impact::{Impact, Setup, Side, compare, solve};
use crate::problem::{BarrierSide, Problem};
use crate::report::{self, ImpactCertificateReport};
use crate::verify::Verdict;
use clap::Args;

use super::answer::{Answer, no_such};
use super::derive::given_values;
use super::files::width;
use super::problem::problem;
use super::{Common, Failure, Format, Outcome, Work, json_text, tolerance};

/// The three phases of a pendulum that hits an elastic barrier, in closed form, checked by
/// Runge-Kutta
#[derive(Args, Default)]
pub struct ImpactArguments {
    /// An equation in quotes, a TOML file, a name of the catalogue, or - for standard input;
    /// without it the paper's swing
    pub problem: Option<String>,
    /// A value, exact (1.5, 3/2, pi/3): A of the release, xc of the barrier, its gamma, parameters;
    /// repeatable
    #[arg(long, value_name = "NAME=VALUE,...")]
    at: Vec<String>,
    /// How the swing of the derived phases is derived, by a method of `lindstedt derive`; without
    /// it the first that passes
    #[arg(long)]
    method: Option<String>,
    /// The order of the law; without it 2 for the paper's reading, for the derived phases the
    /// lowest that passes
    #[arg(long, value_parser = super::count, allow_hyphen_values = true)]
    order: Option<u32>,
    /// What the amplitude of the derived law measures: initial or first-harmonic
    #[arg(long)]
    amplitude: Option<String>,
    /// The whole force of the barrier in the depth d, such as "k*d^2"; without it gamma*d^(3/2)
    #[arg(long, value_name = "FORCE")]
    force: Option<String>,
    /// The law of the contact in the derived phases, such as power-law; without it exact; all for a
    /// table of every law; or one that loses energy ("kelvin-voigt restitution=0.8", hunt-crossley,
    /// kelvin-voigt-no-pull), "all restitution=0.8" for a table of those
    #[arg(long, value_name = "LAW")]
    contact: Option<String>,
    /// The barrier is on the left of xc, and the release at x = A
    #[arg(long)]
    left: bool,
    /// Every method in one table, each at its lowest order that passes
    #[arg(long)]
    compare: bool,
    /// Prove the numbers of the impact of a pendulum and a barrier whose force is a power of the
    /// depth or a sum of them, with a loss by Hunt and Crossley or in a dashpot, and how far each
    /// closed form is off
    #[arg(long, conflicts_with = "compare")]
    certify: bool,
    #[command(flatten)]
    pub common: Common,
}

impl Work for ImpactArguments {
    fn common(&self) -> Common {
        self.common.clone()
    }

    fn input(&self) -> Option<&Path> {
        self.problem.as_deref().and_then(super::problem::path)
    }

    fn run(&self) -> Result<Outcome, Failure> {
        run(self)
    }
}

fn run(arguments: &ImpactArguments) -> Result<Outcome, Failure> {
    let problem = problem_of(arguments)?;
    let tolerance = tolerance(&arguments.common);
    let setup = Setup::try_from(&problem)?;
    let setup = Setup { tolerance, ..setup };
    if arguments.compare {
        return every_method(setup, &arguments.common);
    }
    if arguments.certify {
        return proved(setup, &arguments.common);
    }
    let impact = solve(setup)?;
    let answer = Answer {
        document: &report::impact(&impact, tolerance),
        width: width(arguments.common.output.as_deref()),
        picture: Some(&|| picture(&impact)),
        other: &|format| match format {
            Format::Json => json_text(&json::impact(&impact, tolerance)),
            format => no_such(format),
        },
    };
    let passes = impact.verdicts(tolerance).contains(&Verdict::Pass);
    Ok(Outcome {
        verdict: Some(Verdict::from_passed(passes)),
        ..answer.outcome(&arguments.common)?
    })
}

/// Encloses the numbers of an impact, and with them the errors of its closed forms.
fn proved(setup: Setup, common: &Common) -> Result<Outcome, Failure> {
    let foreign = [
        ("an equation of its own", setup.swing.is_some()),
        ("a table of contact laws", setup.every_contact_law),
    ];
    if let Some((what, _)) = foreign.iter().find(|(_, given)| *given) {
        return Err(Failure::Usage(format!(
            "--certify proves the impact of equation (9), a pendulum against a barrier, not {what}: leave out \
             --certify, whose place Runge-Kutta takes"
        )));
    }
    if common.draws() {
        return Err(Failure::Usage(
            "--certify draws no picture: leave it out, or the picture".to_owned(),
        ));
    }
    let tolerance = tolerance(common);
    let towards = match setup.side {
        Side::Right => 1.0,
        Side::Left => -1.0,
    };
    let exact =
        [-towards * setup.release, towards * setup.barrier, setup.stiffness].map(as_written);
    let [Some(amplitude), Some(barrier), Some(stiffness)] = &exact else {
        return Err(Failure::because("a number of the impact is not finite".to_owned()));
    };
    let force = power_laws(&setup, stiffness)?;
    let dashpot = setup.loss.and_then(|loss| loss.law.dashpot());
    let lossless = match setup.loss {
        None => Some(enclose_impact(amplitude, barrier, &force)?),
        Some(_) => None,
    };
    let impact = solve(setup)?;
    // A restitution gives a damping in doubles, which is taken as the number that is printed.
    let damping = as_written(impact.damping).filter(|_| lossless.is_none());
    let enclosure = match (lossless, &damping) {
        (Some(lossless), _) => lossless,
        (None, Some(damping)) => match dashpot {
            Some(dashpot) => {
                let pulls = dashpot == Dashpot::Pulls;
                enclose_dashpot_impact(amplitude, barrier, stiffness, damping, pulls)?
            }
            None => enclose_lossy_impact(amplitude, barrier, &force, damping)?,
        },
        (None, None) => return Err(Failure::because("the damping is not finite".to_owned())),
    };
    let report = ImpactCertificateReport {
        impact: &impact,
        enclosure: &enclosure,
        exact: [amplitude, barrier],
        force: &force,
        damping: damping.as_ref(),
        tolerance,
    };
    let answer = Answer {
        document: &report::impact_certificate(&report),
        width: width(common.output.as_deref()),
        picture: None,
        other: &|format| match format {
            Format::Json => json_text(&json::impact_certificate(&report)),
            format => no_such(format),
        },
    };
    let passes = report.verdicts().iter().any(|(_, verdict)| *verdict == Verdict::Pass);
    Ok(Outcome { verdict: Some(Verdict::from_passed(passes)), ..answer.outcome(common)? })
}

/// The force of the barrier, which has to be a power of the depth or a sum of them.
fn power_laws(setup: &Setup, stiffness: &Rational) -> Result<Vec<PowerLaw>, Failure> {
    let Some(force) = &setup.force else { return Ok(vec![PowerLaw::hertz(stiffness.clone())]) };
    let mut values: BTreeMap<Symbol, Expr> =
        setup.values.iter().map(|(name, value)| (name, value.clone())).collect();
    values.insert("gamma".into(), Expr::number(stiffness.clone()));
    let laws = force.substitute_all(&values).and_then(|force| PowerLaw::sum_of(&force, "d".into()));
    let refused = |reason: &str| {
        Failure::refused(
            &format!("--certify: the force `{force}` of the barrier {reason}"),
            Some("write it as numbers times powers of the depth, gamma*d^2 + gamma*d^3, or leave out --certify, whose place Runge-Kutta takes".to_owned()),
        )
    };
    match laws {
        Ok(Some(laws)) => Ok(laws),
        Ok(None) => {
            Err(refused("is no sum of powers of the depth d with numbers that are fractions"))
        }
        Err(error) => Err(refused(&format!("is not evaluated: {error}"))),
    }
}

/// A double as the fraction that its decimals say.
fn as_written(value: f64) -> Option<Rational> {
    parse_expression(&value.to_string()).ok()?.as_number().cloned()
}

/// The table of methods.
fn every_method(setup: Setup, common: &Common) -> Result<Outcome, Failure> {
    if setup.method.is_some() {
        return Err(Failure::Usage(
            "--compare takes every method: leave out --method, or `method` in the file".to_owned(),
        ));
    }
    if setup.units.is_some_and(|units| units.yield_limits().next().is_some()) {
        return Err(Failure::Usage(
            "--compare has no pressures: leave out `yield` in the file, or --compare".to_owned(),
        ));
    }
    if setup.every_contact_law {
        return Err(Failure::Usage(
            "--compare is a table of methods, that of every contact law another one: leave out --compare, or `all`"
                .to_owned(),
        ));
    }
    if common.draws() {
        return Err(Failure::Usage(
            "--compare draws no picture: leave out --plot, or --compare".to_owned(),
        ));
    }
    let tolerance = tolerance(common);
    let table = compare(setup)?;
    let answer = Answer {
        document: &report::impact_comparison(&table, tolerance),
        width: width(common.output.as_deref()),
        picture: None,
        other: &|format| match format {
            Format::Json => json_text(&json::impact_comparison(&table, tolerance)),
            format => no_such(format),
        },
    };
    let passes = table.rows.iter().any(|row| row.verdict(tolerance) == Verdict::Pass);
    Ok(Outcome { verdict: Some(Verdict::from_passed(passes)), ..answer.outcome(common)? })
}

/// The problem of the file with what the command line says, which wins.
fn problem_of(arguments: &ImpactArguments) -> Result<Problem, Failure> {
    let mut asked = match &arguments.problem {
        None => Problem::default(),
        Some(text) => problem(text)?,
    };
    for (name, value) in given_values(&arguments.at)? {
        asked.set_value(name.name(), &value.to_string());
    }
    let words = [
        (&arguments.method, &mut asked.method),
        (&arguments.amplitude, &mut asked.amplitude),
        (&arguments.force, &mut asked.contact.force),
        (&arguments.contact, &mut asked.contact.law),
    ];
    for (given, place) in words {
        if given.is_some() {
            place.clone_from(given);
        }
    }
    if let Some(order) = arguments.order {
        asked.order = Some(crate::problem::Order::Power(order));
    }
    if arguments.left {
        asked.pendulum.side = Some(BarrierSide::Left);
    }
    Ok(asked)
}

fn picture(impact: &Impact) -> Result<String, Failure> {
    use crate::export::decimal;
    use crate::export::figure::{CurveStyle, ImpactFigure, ImpactMotion, impact_figure};
    use crate::impact::{PhaseReading, SampledMotion};

    const POINTS: usize = 600;
    let drawn = impact.paths(POINTS);
    let closed_forms = impact.columns.iter().map(|column| match column.reading {
        PhaseReading::Paper => ("closed form, paper", CurveStyle::FORMULA),
        PhaseReading::Energy => ("closed form, energy", CurveStyle::SECOND_FORMULA),
        PhaseReading::Derived => ("closed form, derived", CurveStyle::THIRD_FORMULA),
    });
    let styles = std::iter::once(("Runge-Kutta", CurveStyle::RUNGE_KUTTA)).chain(closed_forms);
    let motion = |(path, (label, style))| {
        let SampledMotion { samples, contact }: &SampledMotion = path;
        ImpactMotion { label, style, samples, contact }
    };
    let motions: Vec<_> = drawn.iter().zip(styles).map(motion).collect();
    let setup = &impact.setup;
    let what = match &setup.swing {
        None => "Pendulum and elastic barrier".to_owned(),
        Some(_) => impact.equation.clone(),
    };
    let release = match setup.side {
        Side::Right if impact.equilibrium == 0.0 => {
            format!("A = {}", decimal(-impact.turning_point))
        }
        _ => format!("{}(0) = {}", impact.letters.coordinate, decimal(impact.turning_point)),
    };
    let stiffness = match &setup.force {
        None => format!(", γ = {}", decimal(setup.stiffness)),
        Some(_) => String::new(),
    };
    let caption = format!(
        "{what}: {release}, {}_c = {}{stiffness}; one period from the release.",
        impact.letters.coordinate,
        decimal(setup.barrier),
    );
    let displacement = format!("displacement {}", impact.letters.coordinate);
    let place = |side| (setup.side == side).then_some(setup.barrier);
    let figure = ImpactFigure {
        left_barrier: place(Side::Left),
        right_barrier: place(Side::Right),
        axes: match &setup.swing {
            None => ["displacement x (rad)", "time t (units of 1/ω)"],
            Some(_) => [&displacement, "time t"],
        },
        motions: &motions,
        caption: &caption,
    };
    Ok(impact_figure(&figure)?)
}

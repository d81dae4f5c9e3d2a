//! The main job: pendulum and elastic barrier, from the equation to three checked phases.
//!
//! ```text
//! x'' + sin x + gamma (x - x_c)^(3/2) H(x - x_c) = 0,   x(0) = -A, x'(0) = 0        (9)
//! approach  x = -A cos(omega t),                omega^2 = 1 - A^2/8 + ... derived     (11)-(13)
//! contact   x'' + x + gamma (p x - q) = 0,      p x - q the fitted line              (14), (15)
//! return    x = A cos(omega (t - t2) + acos(x_c/A))                                   (16)
//! ```
//!
//! The law comes from [`method::solve`] on `x'' + sin x = 0`, the phases from
//! [`three_phases`], the judgement from Runge-Kutta on equation (9) as it stands.

use super::hertz::DEFAULT_STIFFNESS;
use super::judge::{Deviation, TrueImpact, TrueImpactError, assured_impact, deviation};
use super::linearisation::Rule;
use super::model::{DEFAULT_AMPLITUDE, DEFAULT_BARRIER};
use super::phases::{ContactSpeed, Form, PhasesError, Swing, ThreePhases, three_phases};
use crate::expr::{CompiledFunction, EvaluationError, Expr, ExprError};
use crate::method::{self, Refusal};
use crate::numeric::ode::Options;
use crate::oscillator::{Oscillator, OscillatorError};
use crate::solution::Solution;
use crate::symbol::Symbol;
use crate::verify::Verdict;

/// The swing without barrier.
const FREE_SWING: &str = "x'' + sin(x) = 0";

/// The equation that is judged, equation (9).
const WITH_BARRIER: &str = "x'' + sin(x) + gamma*(x - xc)^(3/2)*H(x - xc) = 0";

/// The numbers of an impact.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// Released from rest at `x = -amplitude`, rad.
    pub amplitude: f64,
    /// Position of the barrier, rad.
    pub barrier: f64,
    /// Dimensionless stiffness gamma, positive.
    pub stiffness: f64,
    /// Where gamma comes from, in words.
    pub stiffness_source: String,
    /// Order of the frequency law in the amplitude.
    pub order: u32,
    /// How the line is fitted.
    pub rule: Rule,
    /// Error per step of Runge-Kutta, relative; between 1e-15 and 0.1.
    pub integrator_tolerance: f64,
    /// Steps after which Runge-Kutta gives up, which is an error.
    pub step_limit: u32,
}

/// The paper's pendulum: released at 1.5 rad, the barrier at 0.323, the stiffness of its design by equation (8).
impl Default for Setup {
    fn default() -> Self {
        Self {
            amplitude: DEFAULT_AMPLITUDE,
            barrier: DEFAULT_BARRIER,
            stiffness: DEFAULT_STIFFNESS,
            stiffness_source: "equation (8)".to_owned(),
            order: 2,
            rule: Rule::default(),
            integrator_tolerance: 1e-10,
            step_limit: 250_000,
        }
    }
}

/// The three phases in closed form beside the true motion.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Impact {
    /// What was asked.
    pub setup: Setup,
    /// The equation as it is judged.
    pub equation: String,
    /// The derived law of the free swing.
    pub free_swing: Solution,
    /// Every join continuous, contact speed from the one-term motion.
    pub paper: ThreePhases,
    /// Contact speed from the energy.
    pub energy: ThreePhases,
    /// Runge-Kutta on the original equation.
    pub truth: TrueImpact,
    /// Largest deviation of the paper's column.
    pub paper_deviation: Deviation,
    /// Largest deviation of the energy column.
    pub energy_deviation: Deviation,
}

/// Why there is no impact to report.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImpactError {
    /// The law could not be derived.
    #[error(transparent)]
    Law(#[from] Refusal),
    /// The equation could not be read.
    #[error(transparent)]
    Equation(#[from] OscillatorError),
    /// The equation could not be evaluated.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// There are no three phases.
    #[error(transparent)]
    Phases(#[from] PhasesError),
    /// The true motion could not be followed.
    #[error(transparent)]
    Truth(#[from] TrueImpactError),
}

/// Derives the law, builds both columns and follows the true motion.
///
/// # Errors
/// A barrier out of reach, an amplitude beyond the law or the well, a stiffness that is not positive: see [`ImpactError`].
///
/// ```
/// use lindstedt::impact::{Setup, solve};
///
/// let impact = solve(Setup { stiffness: 1e6, ..Setup::default() })?;
/// let contact = &impact.energy.phases[1];
/// assert!(contact.end > contact.start && contact.form.at(0.0).1 > 0.0); // pressed into the barrier
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve(setup: Setup) -> Result<Impact, ImpactError> {
    let swing = Oscillator::parse(FREE_SWING)?;
    let free_swing = method::solve(
        &swing,
        &method::Options {
            order: Some(setup.order),
            ..Default::default()
        },
    )?;
    let amplitude = |symbol| (symbol == free_swing.amplitude.symbol()).then_some(setup.amplitude);
    let squared = free_swing
        .law
        .frequency_squared()
        .map(|squared| free_swing.evaluate(squared, &amplitude));
    let frequency_squared = squared.and_then(Result::ok).unwrap_or(f64::NAN);

    // Both forces come out of the printed equation, so that phases and judge use what is printed.
    let original = Oscillator::parse(WITH_BARRIER)?;
    let [position, barrier, stiffness] = ["x", "xc", "gamma"].map(Symbol::new);
    let restoring = original.force.substitute(stiffness, &Expr::zero())?;
    let elastic = original
        .force
        .differentiate(stiffness)?
        .substitute(barrier, &Expr::zero())?;
    let linear = restoring.differentiate(position)?.evaluate(&[(position, 0.0)].into())?;
    let (restoring, elastic) = (
        CompiledFunction::new(&restoring, &[position])?,
        CompiledFunction::new(&elastic, &[position])?,
    );
    let restoring_force = |x: f64| restoring.call(&[x]);
    let elastic_force = |depth: f64| elastic.call(&[depth]);

    let phases = |column| {
        three_phases(
            &Swing {
                amplitude: setup.amplitude,
                barrier: setup.barrier,
                stiffness: setup.stiffness,
                frequency_squared,
                linear_stiffness: linear,
                restoring_force: &restoring_force,
                elastic_force: &elastic_force,
                rule: setup.rule,
            },
            column,
        )
    };
    let (paper, energy) = (phases(ContactSpeed::Paper)?, phases(ContactSpeed::Energy)?);
    let options = Options {
        maximum_steps: setup.step_limit as usize,
        ..Options::with_tolerance(setup.integrator_tolerance)
    };
    let truth = assured_impact(
        setup.amplitude,
        setup.barrier,
        setup.stiffness,
        restoring_force,
        elastic_force,
        &options,
    )?;
    let (paper_deviation, energy_deviation) = (deviation(&paper, &truth), deviation(&energy, &truth));
    Ok(Impact {
        equation: original.equation().to_string(),
        setup,
        free_swing,
        paper,
        energy,
        truth,
        paper_deviation,
        energy_deviation,
    })
}

/// One number of an impact: by either column and by Runge-Kutta.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// What it is.
    pub name: &'static str,
    /// By the paper's column.
    pub paper: f64,
    /// By the energy column.
    pub energy: f64,
    /// By Runge-Kutta.
    pub runge_kutta: f64,
}

impl Quantity {
    /// `paper / runge_kutta - 1`.
    pub fn paper_error(&self) -> f64 {
        self.paper / self.runge_kutta - 1.0
    }

    /// `energy / runge_kutta - 1`.
    pub fn energy_error(&self) -> f64 {
        self.energy / self.runge_kutta - 1.0
    }
}

/// A motion over one period, for drawing: time in units of 1/omega, displacement and depth in rad, velocity in rad times omega.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledMotion {
    /// Time, displacement, velocity; the contact, short as it is, has as many points as either flight.
    pub samples: Vec<(f64, f64, f64)>,
    /// Time since touch and depth.
    pub contact: Vec<(f64, f64)>,
}

impl Impact {
    /// Runge-Kutta, the paper's column and the energy column, with so many points a phase.
    pub fn paths(&self, points: usize) -> [SampledMotion; 3] {
        let path = |[touch, exit, end]: [f64; 3], at: &dyn Fn(f64) -> (f64, f64)| {
            let between = |from: f64, to: f64| (0..=points).map(move |k| from + (to - from) * k as f64 / points as f64);
            let times = between(0.0, touch)
                .chain(between(touch, exit))
                .chain(between(exit, end));
            SampledMotion {
                samples: times.map(|t| (t, at(t).0, at(t).1)).collect(),
                contact: between(touch, exit)
                    .map(|t| (t - touch, at(t).0 - self.setup.barrier))
                    .collect(),
            }
        };
        let closed_form = |phases: &ThreePhases| {
            path(phases.phases.map(|phase| phase.end), &|t| {
                (phases.position_at(t), phases.velocity_at(t))
            })
        };
        let truth = &self.truth;
        let true_path = path([truth.touch.t, truth.exit.t, truth.period], &|t| truth.at(t));
        [true_path, closed_form(&self.paper), closed_form(&self.energy)]
    }

    /// Speed, penetration and duration of the contact, the time to it, and the period.
    pub fn quantities(&self) -> [Quantity; 5] {
        let quantity = |name, of: &dyn Fn(&ThreePhases) -> f64, runge_kutta| Quantity {
            name,
            paper: of(&self.paper),
            energy: of(&self.energy),
            runge_kutta,
        };
        [
            quantity("time to contact", &|phases| phases.phases[0].end, self.truth.touch.t),
            quantity("speed", &|phases| phases.speed, self.truth.touch.v),
            quantity("penetration", &|phases| phases.penetration, self.truth.penetration),
            quantity("duration", &|phases| phases.duration, self.truth.duration),
            quantity("period", &|phases| phases.period, self.truth.period),
        ]
    }

    /// omega of the approach and the return, by the law.
    pub fn frequency(&self) -> f64 {
        match self.paper.phases[0].form {
            Form::Cosine { frequency, .. } | Form::Oscillation { frequency, .. } => frequency,
        }
    }

    /// The verdict on a column: every quantity within the tolerance.
    pub fn verdict(&self, column: ContactSpeed, tolerance: f64) -> Verdict {
        Verdict::of(self.shortcomings(column, tolerance).is_empty())
    }

    /// What lies beyond the tolerance in a column: the quantities with their errors, and what of the closed form they come
    /// from.
    pub fn shortcomings(&self, column: ContactSpeed, tolerance: f64) -> Vec<(Vec<(&'static str, f64)>, String)> {
        let order = self.free_swing.order;
        let (speed, met) = match column {
            ContactSpeed::Paper => (
                "the contact begins with the speed of that cosine",
                ", met with that speed",
            ),
            ContactSpeed::Energy => ("the contact begins with the speed from the energy", ""),
        };
        let causes = [
            (
                vec!["time to contact", "period"],
                format!("the swing is one cosine, by the law of order {order}"),
            ),
            (vec!["speed"], speed.to_owned()),
            (
                vec!["penetration", "duration"],
                format!("a line stands for the force of the barrier{met}"),
            ),
        ];
        let beyond = |name: &&str| {
            let quantity = self.quantities().into_iter().find(|quantity| quantity.name == *name)?;
            let error = match column {
                ContactSpeed::Paper => quantity.paper_error(),
                ContactSpeed::Energy => quantity.energy_error(),
            };
            // An error that is no number lies beyond every tolerance.
            let within = error.abs() <= tolerance;
            (!within).then_some((quantity.name, error))
        };
        causes
            .into_iter()
            .map(|(names, cause)| (names.iter().filter_map(beyond).collect::<Vec<_>>(), cause))
            .filter(|(errors, _)| !errors.is_empty())
            .collect()
    }
}

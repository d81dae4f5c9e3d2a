//! A swing and an elastic barrier, from the equation to three verified phases.
//!
//! ```text
//! x'' + sin x + gamma (x - x_c)^(3/2) H(x - x_c) = 0,   x(0) = -A, x'(0) = 0        (9)
//! approach  x = -A cos(omega t),                omega^2 = 1 - A^2/8 + ... derived     (11)-(13)
//! contact   x'' + x + gamma (p x - q) = 0,      p x - q the fitted line              (14), (15)
//! return    x = A cos(omega (t - t2) + acos(x_c/A))                                   (16)
//! ```
//!
//! In: a [`Setup`]. Out: an [`Impact`], one column for each reading. The paper's reading comes
//! first, with its one-term swing by [`method::solve`] and its line by [`three_phases`], then the
//! same with the speed from the energy, then the derived one, with all harmonics and the best
//! contact law; each is compared with Runge-Kutta on the equation as typed. Without a given order
//! or method the derived column uses the first of a sequence that passes, and lists the attempts.

use super::collision::losses;
use super::contact::{ContactLaw, ContactRow};
use super::derived::{DerivedContact, Flight};
use super::error::ImpactError;
use super::form::Form;
use super::judge::{Deviation, TrueImpact};
use super::lossy_laws::{LossyRow, greatest_force};
use super::phases::{ContactSpeed, ImpactProblem, ThreePhases, three_phases};
use super::setup::{ImpactSymbols, Setup};
use super::trial::{Attempt, Trial};
use crate::method::{self, is_odd};
use crate::solution::{Method, Solution};
use crate::verify::Verdict;

/// The three phases in closed form, compared with the true motion.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Impact {
    /// The problem that was solved.
    pub setup: Setup,
    /// The equation on which the closed forms are verified.
    pub equation: String,
    /// The symbols of this equation.
    pub letters: ImpactSymbols,
    /// The equilibrium of the swing, in the unit of x.
    pub equilibrium: f64,
    /// The start of the cycle: the release, or the turning point of a motion released inside the
    /// barrier.
    pub turning_point: f64,
    /// The derived law of the free swing in the paper's reading; `None` if that does not apply.
    pub free_swing: Option<Solution>,
    /// The closed forms, the paper's first.
    pub columns: Vec<JudgedPhases>,
    /// The swing of the derived column.
    pub flight: Option<Flight>,
    /// The contact of the derived column.
    pub contact: Option<DerivedContact>,
    /// Every law of the contact at `energy_speed`; empty if not requested, and if it loses energy.
    pub contact_laws: Vec<ContactRow>,
    /// Every law of a contact that loses energy; empty if not requested.
    pub lossy_laws: Vec<LossyRow>,
    /// lambda of the contact; zero if it loses no energy.
    pub damping: f64,
    /// The greatest force of the true contact, its damping included, per unit of mass.
    pub greatest_force: f64,
    /// Attempts at the derived column, in order, with the reasons of their failure.
    pub tried: Vec<Attempt>,
    /// The speed at the touch from the energy, exact for the equation.
    pub energy_speed: f64,
    /// The reason why the paper's version does not apply; `None` if it does.
    pub no_paper: Option<String>,
    /// Runge-Kutta on the original equation.
    pub truth: TrueImpact,
}

/// The version of the three closed-form phases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhaseReading {
    /// The paper's reading: every join continuous, contact speed from the one-term motion.
    Paper,
    /// As in the paper, with the contact speed from the energy.
    Energy,
    /// The derived motion with all its harmonics, the joins from it.
    Derived,
}

impl PhaseReading {
    /// The name in tables and documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Energy => "energy",
            Self::Derived => "derived",
        }
    }
}

/// The three phases in one reading, judged.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct JudgedPhases {
    /// The version.
    pub reading: PhaseReading,
    /// The closed forms.
    pub phases: ThreePhases,
    /// Its largest deviation from the true motion.
    pub deviation: Deviation,
}

/// Derives the law, builds every column and follows the true motion.
///
/// # Errors
/// A barrier out of reach, an amplitude beyond the law or the well, a stiffness that is not
/// positive: see [`ImpactError`].
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{PhaseReading, Setup, solve};
///
/// let impact = solve(Setup { stiffness: 1e6, ..Setup::default() })?;
/// let derived = impact.column(PhaseReading::Derived).ok_or("none passes")?;
/// let contact = &derived.phases.phases[1];
/// assert!(contact.end > contact.start && contact.phase_point_at(contact.start).1 > 0.0); // pressed into the barrier
/// assert!((derived.phases.penetration / impact.truth.penetration - 1.0).abs() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve(setup: Setup) -> Result<Impact, ImpactError> {
    Trial::run(&setup, |trial| {
        let (derived, tried) = trial.derived(&methods_to_try(&setup));
        let (free_swing, paper, no_paper) = match paper(trial) {
            Ok((law, phases)) => (Some(law), phases, None),
            Err(error) => {
                // If the same method serves both readings, its reason is the only one.
                let alone = tried.iter().all(|attempt| attempt.method == Method::LindstedtPoincare);
                if derived.is_none()
                    && alone
                    && !matches!(
                        error,
                        ImpactError::LosesEnergy
                            | ImpactError::NotOdd { .. }
                            | ImpactError::Expression(_)
                    )
                {
                    return Err(error);
                }
                (None, vec![], Some(error.to_string()))
            }
        };
        let column = |(reading, phases)| JudgedPhases {
            reading,
            deviation: trial.deviation(&phases),
            phases,
        };
        let mut columns: Vec<JudgedPhases> = paper.into_iter().map(column).collect();
        let (flight, contact) = derived
            .map(|derived| {
                columns.push(column((PhaseReading::Derived, derived.phases)));
                (derived.flight, derived.contact)
            })
            .unzip();
        if columns.is_empty() {
            let paper = no_paper.unwrap_or_default();
            return Err(ImpactError::NoReading { paper, tried });
        }
        Ok(Impact {
            setup: setup.clone(),
            equation: trial.equations.judged.clone(),
            letters: trial.equations.letters,
            equilibrium: trial.equations.equilibrium,
            turning_point: trial.turning_point,
            free_swing,
            columns,
            flight,
            contact,
            contact_laws: trial.contact_laws()?,
            lossy_laws: trial.lossy_laws()?,
            damping: trial.collision.damping,
            greatest_force: greatest_force(&trial.collision, &trial.truth),
            tried,
            energy_speed: trial.energy_speed,
            no_paper,
            truth: trial.truth.clone(),
        })
    })
}

/// The methods of the derived column: the one asked for, or the first of these that passes.
fn methods_to_try(setup: &Setup) -> Vec<Method> {
    match (setup.method, setup.order) {
        (Some(method), _) => vec![method],
        (None, Some(_)) => vec![Method::LindstedtPoincare],
        (None, None) => vec![Method::LindstedtPoincare, Method::HarmonicBalance, Method::Exact],
    }
}

/// The order of the law in the paper's reading, if none is given.
const PAPERS_ORDER: u32 = 2;

/// The paper's law and its two readings, by one cosine; the force of the swing must be odd.
pub(super) fn paper(
    trial: &Trial,
) -> Result<(Solution, Vec<(PhaseReading, ThreePhases)>), ImpactError> {
    let Trial { setup, equations, collision, .. } = trial;
    if setup.loss.is_some() {
        return Err(ImpactError::LosesEnergy);
    }
    let swing = &equations.swing;
    if equations.equilibrium != 0.0 || !is_odd(&swing.force, swing.coordinate)? {
        return Err(ImpactError::NotOdd { force: swing.force.to_string() });
    }
    let order = match setup.method {
        None | Some(Method::LindstedtPoincare) => setup.order.unwrap_or(PAPERS_ORDER),
        Some(_) => PAPERS_ORDER,
    };
    let law = method::solve(
        swing,
        &method::Options {
            method: Some(Method::LindstedtPoincare),
            order: Some(order),
            ..Default::default()
        },
    )?;
    let amplitude = -collision.release;
    let values = equations.values.numbers();
    let known = |name| match name == law.amplitude.symbol() {
        true => Some(amplitude),
        false => values.get(&name).copied(),
    };
    let squared = law.law.frequency_squared().map(|squared| law.evaluate(squared, &known));
    let swing = ImpactProblem {
        amplitude,
        barrier: collision.barrier,
        stiffness: collision.stiffness,
        frequency_squared: squared.and_then(Result::ok).unwrap_or(f64::NAN),
        linear_stiffness: equations.slope(0.0),
        restoring_force: collision.restoring_force,
        elastic_force: collision.elastic_force,
        rule: setup.rule,
    };
    let readings =
        [(PhaseReading::Paper, ContactSpeed::Paper), (PhaseReading::Energy, ContactSpeed::Energy)];
    let side = setup.side.sign();
    let phases = readings
        .map(|(reading, speed)| Ok((reading, three_phases(&swing, speed)?.moved(side, 0.0))));
    Ok((law, phases.into_iter().collect::<Result<_, ImpactError>>()?))
}

/// A number of an impact: by Runge-Kutta and by every column.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpactQuantity {
    /// Its name.
    pub name: &'static str,
    /// The value by Runge-Kutta.
    pub runge_kutta: f64,
    /// The values by the columns, in their order.
    pub closed_forms: Vec<f64>,
}

impl ImpactQuantity {
    /// The relative error of each column, `closed form / runge_kutta - 1`.
    pub fn errors(&self) -> impl Iterator<Item = f64> + '_ {
        self.closed_forms.iter().map(|value| value / self.runge_kutta - 1.0)
    }
}

/// A motion over one period, for drawing: time in units of 1/omega, displacement and depth in rad,
/// velocity in rad times omega.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledMotion {
    /// Time, displacement, velocity; the contact, although short, has as many points as each
    /// flight.
    pub samples: Vec<(f64, f64, f64)>,
    /// Time since touch and depth.
    pub contact: Vec<(f64, f64)>,
}

/// Numbers beyond the tolerance, and the part of the closed form that causes them.
pub type Shortcoming = (Vec<(&'static str, f64)>, String);

impl Impact {
    /// The column of a reading; `None` if it has none.
    pub fn column(&self, reading: PhaseReading) -> Option<&JudgedPhases> {
        self.columns.iter().find(|column| column.reading == reading)
    }

    /// The distance of the turning point from the equilibrium, in the unit of x.
    pub fn amplitude(&self) -> f64 {
        (self.turning_point - self.equilibrium).abs()
    }

    /// Whether the contact of the derived column is computed by the exact law and without loss.
    pub fn contact_is_exact(&self) -> bool {
        self.setup.loss.is_none() && self.setup.contact_law == ContactLaw::Exact
    }

    /// The turning point of the true motion after the impact, in the unit of x.
    pub fn place_of_turn(&self) -> f64 {
        self.equilibrium + self.setup.side.sign() * self.truth.phase_point_at(self.truth.period).0
    }

    /// Runge-Kutta and then every column, with this many points a phase.
    pub fn paths(&self, points: usize) -> Vec<SampledMotion> {
        let sign = self.setup.side.sign();
        let path = |[touch, exit, end]: [f64; 3], at: &dyn Fn(f64) -> (f64, f64)| {
            let between = |from: f64, to: f64| {
                (0..=points).map(move |k| from + (to - from) * k as f64 / points as f64)
            };
            let times = between(0.0, touch).chain(between(touch, exit)).chain(between(exit, end));
            SampledMotion {
                samples: times.map(|t| (t, at(t).0, at(t).1)).collect(),
                contact: between(touch, exit)
                    .map(|t| (t - touch, sign * (at(t).0 - self.setup.barrier)))
                    .collect(),
            }
        };
        let closed_form = |column: &JudgedPhases| {
            let phases = &column.phases;
            path(phases.phases.each_ref().map(|phase| phase.end), &|t| {
                (phases.position_at(t), phases.velocity_at(t))
            })
        };
        let truth = &self.truth;
        let true_path = path([truth.touch.t, truth.exit.t, truth.period], &|t| {
            let (z, v) = truth.phase_point_at(t);
            (self.equilibrium + sign * z, sign * v)
        });
        std::iter::once(true_path).chain(self.columns.iter().map(closed_form)).collect()
    }

    /// Speed, penetration and duration of the contact, the time to it, and the period.
    pub fn quantities(&self) -> [ImpactQuantity; 5] {
        const NAMES: [&str; 5] = ["time to contact", "speed", "penetration", "duration", "period"];
        let truth = self.truth.quantities();
        let columns: Vec<[f64; 5]> =
            self.columns.iter().map(|column| column.phases.quantities()).collect();
        std::array::from_fn(|index| ImpactQuantity {
            name: NAMES[index],
            runge_kutta: truth[index],
            closed_forms: columns.iter().map(|numbers| numbers[index]).collect(),
        })
    }

    /// Restitution and exit speed of a contact that loses energy, which are judged, and the energy
    /// lost per unit of mass, which is not, because a small loss has no digits left. `None` without
    /// loss.
    pub fn losses(&self) -> Option<([ImpactQuantity; 2], ImpactQuantity)> {
        self.setup.loss?;
        let truth = losses([self.truth.touch.v, -self.truth.exit.v]);
        let columns = self.columns.iter().map(|column| &column.phases);
        let found: Vec<[f64; 3]> =
            columns.map(|phases| losses([phases.speed, phases.exit_speed])).collect();
        let quantity = |index: usize, name| ImpactQuantity {
            name,
            runge_kutta: truth[index],
            closed_forms: found.iter().map(|numbers| numbers[index]).collect(),
        };
        let judged = [quantity(0, "restitution"), quantity(1, "speed out")];
        Some((judged, quantity(2, "energy lost")))
    }

    /// omega of the approach and the return in the paper's reading.
    pub fn frequency(&self) -> Option<f64> {
        match self.column(PhaseReading::Paper)?.phases.phases[0].form {
            Form::Cosine { frequency, .. } => Some(frequency),
            _ => None,
        }
    }

    /// The largest deviation of a column in approach, contact and return, each on its own clock: of
    /// the flights over the amplitude, of the contact over the true depth.
    pub fn deviations(&self, column: &JudgedPhases) -> [f64; 3] {
        let [approach, contact, back] = column.deviation.aligned;
        [approach / self.amplitude(), contact / self.truth.penetration, back / self.amplitude()]
    }

    /// The verdict on each column: every quantity within the tolerance, and the deviation in every
    /// phase.
    pub fn verdicts(&self, tolerance: f64) -> Vec<Verdict> {
        let passes = |index| Verdict::from_passed(self.shortcomings(index, tolerance).is_empty());
        (0..self.columns.len()).map(passes).collect()
    }

    /// The quantities of a column that are beyond the tolerance, with their errors and the part of
    /// the closed form that they come from.
    pub fn shortcomings(&self, index: usize, tolerance: f64) -> Vec<Shortcoming> {
        let column = &self.columns[index];
        let one_cosine = || {
            let order = self.free_swing.as_ref().map_or(0, |law| law.order);
            format!("the swing is one cosine, by the law of order {order}")
        };
        let [swing, speed, contact] = match column.reading {
            PhaseReading::Paper => [
                one_cosine(),
                "the contact begins with the speed of that cosine".to_owned(),
                "a line stands for the force of the barrier, met with that speed".to_owned(),
            ],
            PhaseReading::Energy => [
                one_cosine(),
                "the contact begins with the speed from the energy".to_owned(),
                "a line stands for the force of the barrier".to_owned(),
            ],
            PhaseReading::Derived => [
                "the derived swing is not closer at this order".to_owned(),
                "the contact begins with the speed of the derived swing".to_owned(),
                match (self.setup.loss, self.setup.contact_law) {
                    (Some(_), _) => "the contact leaves the force of the swing out".to_owned(),
                    (None, ContactLaw::Exact) => "the contact is met with that speed".to_owned(),
                    (None, law) => format!("the contact is that of the law {law}"),
                },
            ],
        };
        let quantities = self.quantities();
        let losses = self.losses().map(|(judged, _)| judged);
        let mut errors: Vec<(&'static str, f64)> = quantities
            .iter()
            .chain(losses.iter().flatten())
            .filter_map(|quantity| Some((quantity.name, quantity.errors().nth(index)?)))
            .collect();
        let [approach, pressed, back] = self.deviations(column);
        errors.extend([
            ("shape of the approach", approach),
            ("shape of the contact", pressed),
            ("shape of the return", back),
        ]);
        let causes: [(&[&str], String); 3] = [
            (&["time to contact", "period", "shape of the approach", "shape of the return"], swing),
            (&["speed"], speed),
            (
                &["penetration", "duration", "shape of the contact", "restitution", "speed out"],
                contact,
            ),
        ];
        // An error that is not a number lies beyond every tolerance.
        let beyond = |names: &[&str]| {
            let those = errors.iter().filter(|(name, _)| names.contains(name));
            those
                .filter(|(_, error)| error.abs() > tolerance || error.is_nan())
                .copied()
                .collect::<Vec<_>>()
        };
        causes
            .into_iter()
            .map(|(names, cause)| (beyond(names), cause))
            .filter(|(errors, _)| !errors.is_empty())
            .collect()
    }
}

//! Kinds `primary` and `primary-sweep`: a main mass that carries the pendulum and its barriers.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
#[cfg(feature = "schema")]
use super::simulation::ROUTES;
use super::sweep::Axis;
use crate::impact::primary::{
    Alone, PrimaryEnergy, PrimaryImpact, PrimaryRow, PrimaryStop, UndampedAndLocked,
};
use crate::impact::{Integrator, Units};
use crate::report::{PrimaryReport, PrimarySweepReport};

/// A main mass on spring and dashpot with a pendulum and its barriers. Time is in units of 1/omega,
/// omega^2 = g/L, displacements of the main mass are over L, energies in units of m g L, angles in
/// radians.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct PrimaryDocument {
    /// The kind of document.
    pub schema: String,
    /// The numbers of both bodies.
    pub parameters: PrimaryParameters,
    /// One unit of time, in seconds.
    pub time_unit: f64,
    /// One unit of displacement of the main mass, L, in metres.
    pub length_unit: f64,
    /// The states at the times asked for.
    pub samples: Vec<PrimarySample>,
    /// The state at the end.
    pub final_state: PrimarySample,
    /// Every impact on a barrier.
    pub impacts: Vec<PrimaryImpact>,
    /// What became of the energy.
    pub energy: PrimaryEnergy,
    /// When the envelope of the main mass has fallen to a tenth, for good; null where it never
    /// does, and where a force drives it.
    pub rest_time: Option<f64>,
    /// Why there is none; null where there is one.
    pub rest_reason: Option<String>,
    /// The largest displacement of the main mass in the last quarter of the run.
    pub long_run: f64,
    /// The same main mass without its damper, in closed form.
    pub without: Alone,
    /// The same with the damper locked, in closed form.
    pub locked: Alone,
    /// How the motion was found: by `integration`, or as a `chain` of closed forms.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ROUTES)))]
    pub route: String,
    /// The number of phases of a chain that were integrated for want of a closed form; null where
    /// the motion was integrated.
    pub integrated_phases: Option<usize>,
    /// The motion of a chain by integration; null where the motion was integrated.
    pub judge: Option<PrimaryJudge>,
    /// The least and the greatest rest time by closed forms of starts 0.03 % smaller and larger: where they are apart, closed forms cannot give this one; null where the motion was
    /// integrated, or one of them does not rest.
    pub nearby_rest_times: Option<[f64; 2]>,
    /// Why the run ended.
    pub stopped: String,
    /// Whether it was followed as long as asked, and its energy is accounted for.
    pub complete: bool,
}

/// The motion of a chain by integration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct PrimaryJudge {
    /// When the envelope of the main mass has fallen to a tenth, for good; null where it never
    /// does, and where a force drives it.
    pub rest_time: Option<f64>,
    /// The largest displacement of the main mass in the last quarter of the run.
    pub long_run: f64,
    /// The number of impacts.
    pub impacts: usize,
}

/// The numbers of main mass and pendulum, dimensionless.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct PrimaryParameters {
    /// R = M/m.
    pub mass: f64,
    /// kappa = k L/(m g).
    pub stiffness: f64,
    /// delta = (c/m) sqrt(L/g).
    pub damping: f64,
    /// f = F/(m g).
    pub force: f64,
    /// eta = Omega sqrt(L/g).
    pub frequency: f64,
    /// The viscous damping ratio of the pendulum.
    pub zeta: f64,
    /// Its dry friction.
    pub alpha: f64,
    /// The stiffness of the contact.
    pub gamma: f64,
    /// The damping of the contact.
    pub mu: f64,
    /// The place of the left barrier, in radians; null where there is none.
    pub left: Option<f64>,
    /// The place of the right barrier, likewise.
    pub right: Option<f64>,
    /// The start: angle, its velocity, displacement of the main mass, its velocity.
    pub start: [f64; 4],
}

/// Both bodies at a time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct PrimarySample {
    /// The time.
    pub t: f64,
    /// The angle of the pendulum.
    pub x: f64,
    /// Its velocity.
    pub velocity: f64,
    /// The displacement of the main mass.
    pub y: f64,
    /// Its velocity.
    pub speed: f64,
}

/// Many runs of a main mass with its pendulum, over every combination of the values of some
/// parameters. Units as in kind `primary`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct PrimarySweepDocument {
    /// The kind of document.
    pub schema: String,
    /// The parameters that are varied, in SI units unless they are numbers of equation (7); the
    /// last varies fastest.
    pub axes: Vec<Axis>,
    /// One unit of time, in seconds; null where the runs differ in it.
    pub time_unit: Option<f64>,
    /// One unit of displacement of the main mass, L, in metres; null where the runs differ in it.
    pub length_unit: Option<f64>,
    /// A row for every run.
    pub rows: Vec<PrimarySweepRow>,
}

/// One run of a main mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct PrimarySweepRow {
    /// The values of the parameters, in the order of the axes.
    pub values: Vec<f64>,
    /// eta, the frequency of the force over omega.
    pub frequency: f64,
    /// The largest displacement in the last quarter of the run, with its damper; null for a run
    /// that was stopped before it began.
    pub amplitude: Option<f64>,
    /// The amplitude in the long run with the damper locked; null at an undamped resonance, and
    /// where no force drives it.
    pub locked: Option<f64>,
    /// That amplitude without the damper.
    pub without: Option<f64>,
    /// The number of impacts in the last quarter of the run; null for a run that was stopped before
    /// it began.
    pub impacts: Option<usize>,
    /// The number of impacts in the whole run; null likewise.
    pub all_impacts: Option<usize>,
    /// When the envelope of the main mass has fallen to a tenth, for good; null where it never
    /// does, and where a force drives it.
    pub rest_time: Option<f64>,
    /// The rest time with the damper locked; null where it never rests, creeps, or a force drives
    /// it.
    pub rest_locked: Option<f64>,
    /// The rest time without the damper; null likewise.
    pub rest_without: Option<f64>,
    /// One unit of time in this run, in seconds.
    pub time_unit: f64,
    /// One unit of displacement of the main mass in this run, L, in metres.
    pub length_unit: f64,
    /// Whether the run was followed as long as asked.
    pub complete: bool,
}

/// The document of kind `primary`.
///
/// ```
/// use lindstedt::impact::primary::simulate_primary;
/// use lindstedt::problem::Problem;
/// use lindstedt::report::PrimaryReport;
///
/// let file: Problem = "[primary]\nmass = 0.56\nstiffness = 80\ndisplacement = 0.02\n[run]\nduration = 20".parse()?;
/// let asked = file.primary_case(&[])?;
/// let motion = simulate_primary(asked.case, &asked.settings)?;
/// let document = lindstedt::export::json::primary(&PrimaryReport { motion: &motion, units: &asked.units, samples: &[], judge: None, nearby: None });
/// assert!(document.complete && document.energy.residual < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn primary(report: &PrimaryReport) -> PrimaryDocument {
    let motion = report.motion;
    let case = &motion.case;
    let (own, model) = (&case.primary, &case.model);
    let sample = |t: f64| {
        let state = motion.state_at(t)?;
        Some(PrimarySample {
            t,
            x: state.x,
            velocity: state.velocity,
            y: state.y,
            speed: state.speed,
        })
    };
    let [x, velocity, y, speed] = case.start;
    let start = PrimarySample { t: 0.0, x, velocity, y, speed };
    let others = own.undamped_and_locked();
    let driven = own.force != 0.0;
    let rest = motion.rest_time();
    PrimaryDocument {
        schema: DocumentKind::Primary.schema().to_owned(),
        parameters: PrimaryParameters {
            mass: own.mass,
            stiffness: own.stiffness,
            damping: own.damping,
            force: own.force,
            frequency: own.frequency,
            zeta: model.zeta,
            alpha: model.alpha,
            gamma: model.gamma,
            mu: model.mu,
            left: model.left,
            right: model.right,
            start: case.start,
        },
        time_unit: report.units.time(),
        length_unit: report.units.length,
        samples: report.samples.iter().filter_map(|t| sample(*t)).collect(),
        final_state: sample(motion.end).unwrap_or(start),
        impacts: motion.impacts.clone(),
        energy: motion.energy,
        rest_time: rest.as_ref().ok().copied().filter(|_| !driven),
        rest_reason: match (driven, rest) {
            (true, _) => Some("a force drives it".to_owned()),
            (false, Err(reason)) => Some(reason.to_string()),
            (false, Ok(_)) => None,
        },
        long_run: motion.largest_since(0.75 * motion.end),
        without: others.without,
        locked: others.locked,
        route: if motion.by_chain { Integrator::Chain } else { Integrator::Taylor }
            .route()
            .to_owned(),
        integrated_phases: motion.by_chain.then_some(motion.integrated),
        judge: report.judge.map(|judge| PrimaryJudge {
            rest_time: judge.rest_time().ok().filter(|_| !driven),
            long_run: judge.largest_since(0.75 * judge.end),
            impacts: judge.impacts.len(),
        }),
        nearby_rest_times: report.nearby,
        stopped: motion.stop.to_string(),
        complete: report.is_complete(),
    }
}

/// The document of kind `primary-sweep`.
///
/// ```
/// use lindstedt::impact::primary::sweep_primary;
/// use lindstedt::impact::sweep::Axis;
/// use lindstedt::problem::Problem;
/// use lindstedt::report::PrimarySweepReport;
///
/// let file: Problem = "[primary]\nmass = 0.56\nstiffness = 80\nforce = 0.01\ndamping = 0.5\n[run]\nduration = 20".parse()?;
/// let (axis, parameter): (Axis, _) = ("frequency=9:11:2".parse()?, "frequency".parse()?);
/// let asked: Result<Vec<_>, _> = axis.values().iter().map(|value| file.primary_case(&[(parameter, *value)])).collect();
/// let (motions, units): (Vec<_>, Vec<_>) = asked?.into_iter().map(|asked| ((asked.case, asked.settings), asked.units)).unzip();
/// let rows = sweep_primary(&motions, |_| ()).map_err(|(_, error)| error)?;
/// let report = PrimarySweepReport { axes: &[axis], parameters: &[parameter], rows: &rows, units: &units };
/// assert_eq!(lindstedt::export::json::primary_sweep(&report).rows[1].values, [11.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn primary_sweep(report: &PrimarySweepReport) -> PrimarySweepDocument {
    let row = |(number, (row, units)): (usize, (&PrimaryRow, &Units))| {
        let UndampedAndLocked { locked, without } = row.others;
        let begun = row.is_begun();
        PrimarySweepRow {
            values: report.values(number),
            frequency: row.primary.frequency,
            amplitude: begun.then_some(row.amplitude),
            locked: locked.amplitude,
            without: without.amplitude,
            impacts: begun.then_some(row.impacts),
            all_impacts: begun.then_some(row.all_impacts),
            rest_time: row.rest_time.ok().filter(|_| !row.is_driven()),
            rest_locked: locked.rest_time,
            rest_without: without.rest_time,
            time_unit: units.time(),
            length_unit: units.length,
            complete: row.stop == PrimaryStop::Duration,
        }
    };
    let rows: Vec<PrimarySweepRow> =
        report.rows.iter().zip(report.units).enumerate().map(row).collect();
    let common = |unit: fn(&PrimarySweepRow) -> f64| {
        let first = rows.first().map(unit)?;
        rows.iter().all(|row| unit(row) == first).then_some(first)
    };
    PrimarySweepDocument {
        schema: DocumentKind::PrimarySweep.schema().to_owned(),
        axes: report.axes.iter().map(Axis::from).collect(),
        time_unit: common(|row| row.time_unit),
        length_unit: common(|row| row.length_unit),
        rows,
    }
}

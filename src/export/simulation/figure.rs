//! Pictures: x(t), the phase plane and the energy of one run; curves or a heat map of a sweep.

#[cfg(feature = "plot")]
use super::heat_map::heat_map;
use super::{Report, SweepReport};
use crate::decimal::decimal;
use crate::export::figure::{
    CurveStyle, FigureError, GuideLine, Panel, Points, Scale, curve, figure, panel,
};
use crate::impact::sweep::{Axis, Spacing, Summary};
use crate::impact::{Integrator, Simulation};

/// Number of points of a curve, equally spaced in time; the turning points are added.
const POINTS: usize = 1600;

/// The motion at equal distances of time and at its turning points, so that no peak is cut.
fn points(motion: &Simulation) -> Vec<(f64, f64, f64)> {
    let mut times: Vec<f64> =
        (0..=POINTS).map(|index| motion.end_time * (index as f64 / POINTS as f64)).collect();
    times.extend(motion.turns.iter().map(|turn| turn.t));
    times.extend(
        motion
            .impacts
            .iter()
            .flat_map(|impact| [Some(impact.entry_time), impact.exit_time])
            .flatten(),
    );
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
        .into_iter()
        .filter_map(|t| motion.path.phase_point_at(t).map(|(x, velocity)| (t, x, velocity)))
        .collect()
}

/// The motion in time, the phase plane, and the energy balance.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::export::simulation::{Report, figure};
/// use lindstedt::impact::{Case, Integrator, Settings, simulate};
///
/// let (model, start) = Case { zeta: 0.05, ..Case::default() }.motion()?;
/// let motion = simulate(&model, start, Integrator::Taylor, &Settings::default())?;
/// let report = Report { motion: &motion, judge: None, sources: ["given", "given"], tolerance: 1e-10, samples: &[1.0], baseline: None, dissipation: None, units: None, known_until: None };
/// assert!(figure::simulation(&report)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulation(report: &Report) -> Result<String, FigureError> {
    let motion = report.motion;
    let model = &motion.model;
    let own_name = match motion.integrator {
        Integrator::Chain => "closed forms",
        Integrator::Taylor | Integrator::RungeKutta => "motion",
    };
    let judge_name = match motion.integrator {
        Integrator::Chain => "integration",
        Integrator::Taylor | Integrator::RungeKutta => "Runge-Kutta",
    };
    let own = DrawnMotion::new(own_name, motion);
    let judge = report.judge.map(|judge| DrawnMotion::new(judge_name, judge));
    let style = match judge {
        Some(_) => CurveStyle::FORMULA,
        None => CurveStyle::DIFFERENCE,
    };
    let curves = |of: fn(&DrawnMotion) -> &Points| {
        let judge = judge.as_ref();
        let judge = judge.map(|judge| curve(judge.name, of(judge), CurveStyle::RUNGE_KUTTA));
        judge.into_iter().chain([curve(own.name, of(&own), style)]).collect()
    };
    let guides = |guide: fn(f64, &'static str) -> GuideLine<'static>| -> Vec<GuideLine<'static>> {
        let left = model.left.map(|at| guide(at, "left barrier"));
        let right = model.right.map(|at| guide(at, "barrier x_c"));
        // A barrier out of reach is left out, because the axis would leave no room for the motion.
        match motion.touches() {
            true => left.into_iter().chain(right).collect(),
            false => Vec::new(),
        }
    };
    let works = works(motion);
    let energies = works.iter().map(|(label, points, style)| curve(label, points, *style));
    let panels = [
        panel(
            "Motion in time",
            [TIME, "displacement x (rad)"],
            curves(|drawn| &drawn.time),
            guides(GuideLine::Y),
        ),
        panel(
            "Phase plane",
            ["displacement x (rad)", "velocity x′"],
            curves(|drawn| &drawn.phase),
            guides(GuideLine::X),
        ),
        panel("Energy", [TIME, "energy (units of m g L)"], energies.collect(), vec![]),
    ];
    let caption = format!(
        "Equation (7): γ = {}, μ = {}, ζ = {}, α = {}, β = {}; {} impacts until t = {}.",
        decimal(model.gamma),
        decimal(model.mu),
        decimal(model.zeta),
        decimal(model.alpha),
        decimal(model.beta),
        motion.impacts.len(),
        decimal(motion.end_time)
    );
    figure(&panels, &caption)
}

/// A motion as it is drawn.
struct DrawnMotion {
    name: &'static str,
    /// x against t.
    time: Points,
    /// x' against x.
    phase: Points,
}

impl DrawnMotion {
    fn new(name: &'static str, motion: &Simulation) -> Self {
        let points = points(motion);
        Self {
            name,
            time: points.iter().map(|&(t, x, _)| (t, x)).collect(),
            phase: points.iter().map(|&(_, x, velocity)| (x, velocity)).collect(),
        }
    }
}

/// The energy in time, and the work of every force that acts.
fn works(motion: &Simulation) -> Vec<(&'static str, Points, CurveStyle)> {
    let model = &motion.model;
    let (mut energy, mut viscous, mut friction, mut contact, mut excitation) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
    motion.energy_points(motion.end_time / POINTS as f64, |point| {
        energy.push((point.t, point.energy));
        viscous.push((point.t, point.book.viscous));
        friction.push((point.t, point.book.friction));
        contact.push((point.t, point.book.contact));
        excitation.push((point.t, point.book.excitation));
    });
    let all = [
        (true, "energy", energy, CurveStyle::FORMULA),
        (model.zeta != 0.0, "work of viscous damping", viscous, CurveStyle::SECOND_DIFFERENCE),
        (model.alpha != 0.0, "work of dry friction", friction, CurveStyle::SERIES[5]),
        (model.mu != 0.0, "work of contact damping", contact, CurveStyle::THIRD_DIFFERENCE),
        (model.beta != 0.0, "work of the excitation", excitation, CurveStyle::SECOND_FORMULA),
    ];
    let acting = all.into_iter().filter(|(acts, ..)| *acts);
    acting.map(|(_, label, points, style)| (label, points, style)).collect()
}

const TIME: &str = "time t (units of 1/ω)";

/// A quantity of a sweep.
pub(super) struct SweepQuantity {
    pub(super) title: &'static str,
    pub(super) label: &'static str,
    /// The name of the quantity, for the message about motions that do not have it.
    name: &'static str,
    value: fn(&Summary) -> Option<f64>,
}

pub(super) const QUANTITIES: [SweepQuantity; 4] = [
    SweepQuantity {
        title: "Rest time",
        label: "rest time (units of 1/ω)",
        name: "rest time",
        value: |summary| summary.rest_time.ok(),
    },
    SweepQuantity {
        title: "Impacts",
        label: "number of impacts",
        name: "impacts",
        value: |summary| summary.is_begun().then_some(summary.impacts as f64),
    },
    SweepQuantity {
        title: "Deepest penetration",
        label: "penetration (rad)",
        name: "penetration",
        value: |summary| summary.is_begun().then_some(summary.deepest),
    },
    SweepQuantity {
        title: "Energy lost in contact",
        label: "energy (units of m g L)",
        name: "energy",
        value: |summary| summary.is_begun().then_some(summary.energy_lost),
    },
];

/// The label of a swept parameter at an axis, with its unit, and its symbol in a caption.
fn parameter(name: &str) -> [&str; 2] {
    match name {
        "amplitude" => ["amplitude A (rad)", "A"],
        "start" => ["start x(0) (rad)", "x(0)"],
        "speed" => ["start x′(0)", "x′(0)"],
        "barrier" => ["barrier x_c (rad)", "x_c"],
        "gamma" => ["stiffness γ", "γ"],
        "mu" => ["contact damping μ", "μ"],
        "mu_over_gamma" => ["contact damping μ/γ", "μ/γ"],
        "lambda" => ["contact damping λ (s/m)", "λ"],
        "restitution" => ["restitution e", "e"],
        "at_speed" => ["speed of the restitution", "v"],
        "damping" => ["contact damping c (N s/m^(5/2))", "c"],
        "zeta" => ["damping ratio ζ", "ζ"],
        "viscous" => ["viscous damping c (N s/m)", "c"],
        "alpha" => ["friction α", "α"],
        "torque" => ["torque of friction (N m)", "torque"],
        "beta" => ["excitation β", "β"],
        "frequency_ratio" => ["frequency ratio Ω/ω", "Ω/ω"],
        "mass" => ["mass m (kg)", "m"],
        "radius" => ["radius R (m)", "R"],
        "length" => ["length L (m)", "L"],
        "modulus" => ["modulus E (Pa)", "E"],
        "gravity" => ["gravity g (m/s²)", "g"],
        other => [other, other],
    }
}

/// The range of an axis in words: `ζ from 0.01 to 0.05`.
fn range(axis: &Axis) -> String {
    let [_, symbol] = parameter(axis.name());
    let [from, to] = axis.ends().map(decimal);
    match axis.spacing() {
        Spacing::List if axis.values().len() <= 8 => {
            let values: Vec<String> = axis.values().iter().map(|value| decimal(*value)).collect();
            format!("{symbol} = {}", values.join(", "))
        }
        Spacing::List => format!("{} values of {symbol}", axis.values().len()),
        Spacing::Linear | Spacing::Logarithmic => format!("{symbol} from {from} to {to}"),
    }
}

/// The label of an axis: a logarithmic one of negative values shows their sizes.
pub(super) fn axis_label(axis: &Axis) -> String {
    let [label, _] = parameter(axis.name());
    match axis.spacing() {
        Spacing::Logarithmic if axis.ends()[0] < 0.0 => format!("size of {label}"),
        _ => label.to_owned(),
    }
}

/// Curves over one parameter, or a heat map over two: of the rest time where a motion has one,
/// otherwise of the number of impacts.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::export::simulation::{SweepReport, figure};
/// use lindstedt::impact::{Integrator, Model, Settings, Start, sweep::{Axis, sweep}};
///
/// let axes: [Axis; 1] = ["zeta=0.02:0.1:3".parse()?];
/// let start = Start { x: -1.5, velocity: 0.0 };
/// let motions: Vec<_> = axes[0].values().iter().map(|&zeta| (Model { zeta, ..Model::default() }, start)).collect();
/// let rows = sweep(&motions, Integrator::Taylor, &Settings::default(), |_done| {}).map_err(|(_, error)| error)?;
/// let report = SweepReport { axes: &axes, rows: &rows };
/// assert!(figure::sweep(&report)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep(report: &SweepReport) -> Result<String, FigureError> {
    match report.axes {
        [one] => {
            let (x_scale, values): (Scale, Vec<f64>) = match one.spacing() {
                Spacing::Logarithmic => {
                    (Scale::Logarithmic, one.values().iter().map(|value| value.abs()).collect())
                }
                Spacing::Linear | Spacing::List => (Scale::Linear, one.values().to_vec()),
            };
            // The values of a list need not be sorted, those of a curve must be.
            let mut order: Vec<usize> = (0..values.len()).collect();
            order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
            let x_label = axis_label(one);
            // A motion without the quantity interrupts the curve, and a single point is not drawn.
            let runs = |quantity: &SweepQuantity| -> Vec<Points> {
                let found: Vec<Option<(f64, f64)>> = order
                    .iter()
                    .map(|&index| Some((values[index], (quantity.value)(report.rows.get(index)?)?)))
                    .collect();
                let unbroken = found.split(Option::is_none).filter(|run| run.len() > 1);
                unbroken.map(|run| run.iter().copied().flatten().collect()).collect()
            };
            let drawn: Vec<(&SweepQuantity, Vec<Points>)> = QUANTITIES
                .iter()
                .map(|quantity| (quantity, runs(quantity)))
                .filter(|(_, runs)| !runs.is_empty())
                .collect();
            let panels: Vec<Panel> = drawn
                .iter()
                .map(|(quantity, runs)| {
                    let curves =
                        runs.iter().map(|points| curve("", points, CurveStyle::DIFFERENCE));
                    let labels = [x_label.as_str(), quantity.label];
                    Panel { x_scale, ..panel(quantity.title, labels, curves.collect(), vec![]) }
                })
                .collect();
            let restless = report.rows.iter().filter(|row| row.rest_time.is_err()).count();
            let mut caption = format!("{} motions, {}.", report.rows.len(), range(one));
            if restless > 0 {
                caption.push_str(&format!(" No rest time in {restless} of them."));
            }
            figure(&panels, &caption)
        }
        [down, across] => {
            let [rest, impacts, ..] = &QUANTITIES;
            let restless = report.rows.iter().filter(|row| row.rest_time.is_err()).count();
            let total = report.rows.len();
            let quantity = if restless < total { rest } else { impacts };
            let grid: Vec<Vec<f64>> = report
                .rows
                .chunks(across.values().len())
                .map(|row| {
                    row.iter()
                        .map(|summary| (quantity.value)(summary).unwrap_or(f64::NAN))
                        .collect()
                })
                .collect();
            let mut caption = format!("{total} motions, {} and {}.", range(down), range(across));
            match restless {
                0 => {}
                _ if restless < total => {
                    caption.push_str(&format!(
                        " Grey: no {} within the run, {restless} of them.",
                        quantity.name
                    ));
                }
                _ => caption.push_str(" None of them has a rest time within the run."),
            }
            heat_map(&grid, [down, across], quantity, &caption)
        }
        _ => Err(FigureError::Empty("the sweep".to_owned())),
    }
}

#[cfg(not(feature = "plot"))]
fn heat_map(
    _: &[Vec<f64>],
    _: [&Axis; 2],
    _: &SweepQuantity,
    _: &str,
) -> Result<String, FigureError> {
    Err(FigureError::LeftOut)
}

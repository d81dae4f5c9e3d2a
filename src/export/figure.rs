//! Figures: curves of numbers in, one SVG text out. The library kuva draws; this module checks the
//! data, sets the style, and has three complete figures, [`impact_figure`], [`motion_figure`] and
//! [`backbone_figure`].
//!
//! Equal numbers give equal bytes. Colours are those of Okabe and Ito, *Color Universal Design*
//! (2008). Curves are thinned to about 2000 points; an axis whose values agree to 1e-9 shows a
//! constant. A point that is not finite is an error, never a silent gap. On a logarithmic axis
//! negative values are an error, and zeros, at which an error curve meets its reference, are left
//! out. Without the feature `plot` every figure is [`FigureError::LeftOut`].
//!
//! ```
//! use lindstedt::export::figure::{Curve, CurveStyle, Panel, figure};
//!
//! let wave: Vec<(f64, f64)> = (0..200).map(|i| f64::from(i) * 0.05).map(|t| (t, t.cos())).collect();
//! let curve = Curve { label: "cos t", points: &wave, style: CurveStyle::FORMULA };
//! let panel = Panel { title: "Linear oscillator", x_label: "time t (s)", curves: vec![curve], ..Panel::default() };
//! let svg = figure(&[panel], "Free vibration.")?;
//! assert!(svg.starts_with("<svg") && svg.contains("cos t"));
//! # Ok::<(), lindstedt::export::figure::FigureError>(())
//! ```

#[cfg(feature = "plot")]
mod drawing;

use crate::impact::MaterialsError;
use crate::verify::comparison::Backbone;
#[cfg(feature = "plot")]
use drawing::arranged;
#[cfg(feature = "plot")]
pub(super) use drawing::{power_of_ten, written};

/// Colour (Okabe and Ito), dash pattern and width of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveStyle(&'static str, &'static str, f64);

impl CurveStyle {
    /// The truth by Runge-Kutta: broad, light and solid; give it first, so that formulas lie over
    /// it.
    pub const RUNGE_KUTTA: Self = Self("#56b4e9", "none", 4.5);
    /// A closed form: dark and dashed.
    pub const FORMULA: Self = Self("#d55e00", "6 3", 2.0);
    /// A second closed form beside the first: thin, black and dotted.
    pub const SECOND_FORMULA: Self = Self("#000000", "2 3", 1.5);
    /// A third closed form: green, thin and solid.
    pub const THIRD_FORMULA: Self = Self("#009e73", "none", 1.3);
    /// A difference or an error: thin and solid.
    pub const DIFFERENCE: Self = Self("#0072b2", "none", 1.6);
    /// One of a series, such as the errors of successive orders, after [`Self::DIFFERENCE`].
    pub const SECOND_DIFFERENCE: Self = Self("#cc79a7", "7 2", 1.6);
    /// The next of a series.
    pub const THIRD_DIFFERENCE: Self = Self("#009e73", "2 2", 1.8);
    /// Curves of one panel that must be told apart, in print and in colour-blind vision: colour and
    /// dashes both differ.
    pub const SERIES: [Self; 12] = [
        Self("#d55e00", "none", 1.6),
        Self("#0072b2", "7 3", 1.6),
        Self("#009e73", "2 2", 1.8),
        Self("#cc79a7", "10 3 2 3", 1.6),
        Self("#000000", "4 2", 1.3),
        Self("#e69f00", "none", 1.6),
        Self("#000000", "1 3", 1.6),
        Self("#d55e00", "5 2 1 2", 1.6),
        Self("#0072b2", "2 4", 1.8),
        Self("#009e73", "9 2", 1.6),
        Self("#cc79a7", "3 2", 1.6),
        Self("#e69f00", "8 2 2 2 2 2", 1.6),
    ];
    /// Points that are not joined: small and grey, such as many designs.
    pub const POINTS: Self = Self("#56b4e9", POINTS, 2.2);
    /// Points that stand out.
    pub const MARKED_POINTS: Self = Self("#d55e00", POINTS, 4.5);
    /// A closed form point by point.
    pub const SLOW: Self = Self("#000000", POINTS, 1.0);
    /// Points that form a pattern together.
    pub const DOTS: Self = Self("#0072b2", POINTS, 1.1);
    /// A second kind of points that stand out.
    pub const SECOND_MARKED_POINTS: Self = Self("#000000", POINTS, 4.5);
    /// A third kind of points that stand out.
    pub const THIRD_MARKED_POINTS: Self = Self("#009e73", POINTS, 4.5);
    /// A fourth kind of points that stand out.
    pub const FOURTH_MARKED_POINTS: Self = Self("#cc79a7", POINTS, 4.5);
    /// Simulated motions, drawn over the curve on which they should lie: small and light.
    pub const SIMULATED: Self = Self("#56b4e9", POINTS, 3.2);
    /// Unstable motions: in the colour of [`Self::DIFFERENCE`], dashed.
    pub const UNSTABLE: Self = Self("#0072b2", "5 3", 1.3);
    /// Free motions without damping: thin and grey.
    pub const BACKBONE: Self = Self("#777777", "none", 0.9);
    /// Stable equilibria: thin, black and solid.
    pub const EQUILIBRIUM: Self = Self("#000000", "none", 1.2);
    /// Unstable equilibria: thin, black and dashed.
    pub const UNSTABLE_EQUILIBRIUM: Self = Self("#000000", "5 3", 0.9);
    /// Places without a stable motion.
    pub const NO_MOTION: Self = Self("#bbbbbb", POINTS, 1.0);
    /// Places with one stable motion.
    pub const ONE_MOTION: Self = Self("#56b4e9", POINTS, 1.6);
    /// Places with two stable motions.
    pub const TWO_MOTIONS: Self = Self("#e69f00", POINTS, 2.2);
    /// Places with more stable motions.
    pub const MANY_MOTIONS: Self = Self("#cc79a7", POINTS, 2.8);
    /// The number of regions of a plane that have colours of their own.
    pub const REGIONS: usize = 6;
    /// The style of the bars of which a region of a plane is made, this wide: of the numbered ones, then of all
    /// others.
    pub fn region(index: usize, width: f64) -> Self {
        const COLOURS: [&str; CurveStyle::REGIONS + 1] =
            ["#56b4e9", "#e69f00", "#009e73", "#cc79a7", "#0072b2", "#d55e00", "#f0e442"];
        Self(COLOURS[index.min(Self::REGIONS)], "none", width)
    }
    /// The style of the bars of what belongs to no region, this wide.
    pub fn no_region(width: f64) -> Self {
        Self("#dddddd", "none", width)
    }
    /// The style of the bars of what lies outside of all regions, this wide.
    pub fn outside(width: f64) -> Self {
        Self("#888888", "none", width)
    }
    /// One of many curves, which need not be distinguished.
    pub const ONE_OF_MANY: Self = Self("#bbbbbb", "none", 0.7);
    #[cfg(feature = "plot")]
    const GUIDE: Self = Self("#777777", "none", 1.0);
}

/// The value that stands for points in place of a dash pattern.
const POINTS: &str = "points";

/// One line of a panel.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// Words for the legend; curves with the same label and style share one entry, an empty label
    /// has none.
    pub label: &'a str,
    /// Two or more points (abscissa, ordinate) in the units of the axes, in the order in which they
    /// are joined.
    pub points: &'a [(f64, f64)],
    /// Colour, dash and width.
    pub style: CurveStyle,
}

/// Points of one curve.
pub(super) type Points = Vec<(f64, f64)>;

/// A thin grey line across a panel, always inside the axes, with words for the legend or none.
#[derive(Clone, Copy, Debug)]
pub enum GuideLine<'a> {
    /// A vertical line at a value of the abscissa.
    X(f64, &'a str),
    /// A horizontal line at a value of the ordinate.
    Y(f64, &'a str),
}

/// The scale of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps are equal distances.
    #[default]
    Linear,
    /// Equal ratios are equal distances.
    Logarithmic,
}

/// One pair of axes with what is drawn on it.
#[derive(Clone, Debug, Default)]
pub struct Panel<'a> {
    /// Short title.
    pub title: &'a str,
    /// Quantity and, last and in parentheses, unit: `time t (s)`. Very large or small numbers are
    /// divided by a power of ten, which is named there: `time t (10⁻⁶ s)`.
    pub x_label: &'a str,
    /// Quantity and unit of the ordinate, in the same form.
    pub y_label: &'a str,
    /// Division of the abscissa.
    pub x_scale: Scale,
    /// Division of the ordinate.
    pub y_scale: Scale,
    /// The curves, the last on top; at least one.
    pub curves: Vec<Curve<'a>>,
    /// Lines across the panel.
    pub guides: Vec<GuideLine<'a>>,
}

/// The reason why there is no figure.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// There is no panel, or a panel (named) has no curve.
    #[error("nothing to draw in {0}: leave it out or give it data")]
    Empty(String),
    /// A curve (named) with fewer than two points to join.
    #[error(
        "{0} has fewer than 2 points to join (zeros on a logarithmic axis do not count): give more samples"
    )]
    TooFewPoints(String),
    /// A curve or guide and its number (named) that is not finite, or not positive on a logarithmic
    /// axis.
    #[error(
        "{0} has no place on the axes: stop the curve before it; for a logarithmic axis give sizes"
    )]
    OffAxes(String),
    /// Formula and truth part at this sample.
    #[error(
        "formula and truth must be sampled at the same times, but differ at sample {0}: sample both alike"
    )]
    DifferentTimes(usize),
    /// The library was built without the feature `plot`.
    #[error("this build draws no pictures: build it with the feature `plot`")]
    LeftOut,
    /// A motion to be drawn cannot be followed.
    #[error(transparent)]
    Study(#[from] MaterialsError),
}

/// One motion of the impact oscillator: a column of the answer, or Runge-Kutta.
#[derive(Clone, Copy, Debug)]
pub struct ImpactMotion<'a> {
    /// Words for the legend.
    pub label: &'a str,
    /// Colour, dash and width.
    pub style: CurveStyle,
    /// Samples (t, x, x'): for the pendulum t in units of 1/omega, x in rad, x' = dx/d(omega t).
    pub samples: &'a [(f64, f64, f64)],
    /// One contact: (time since touch, depth), in the same units; empty if there is none.
    pub contact: &'a [(f64, f64)],
}

/// The data of [`impact_figure`].
#[derive(Clone, Copy, Debug)]
pub struct ImpactFigure<'a> {
    /// Barrier on the left, in the unit of x.
    pub left_barrier: Option<f64>,
    /// Barrier on the right, in the unit of x.
    pub right_barrier: Option<f64>,
    /// The coordinate with its unit, `displacement x (rad)`, and time with its own,
    /// `time t (units of 1/ω)`.
    pub axes: [&'a str; 2],
    /// The motions, drawn in this order: Runge-Kutta first, formulas over it.
    pub motions: &'a [ImpactMotion<'a>],
    /// Words below the figure, or empty.
    pub caption: &'a str,
}

/// The pendulum against its barrier: phase plane x, x'; displacement x(t); and, where a motion has
/// a contact, the contact enlarged, penetration x - x_c against time since touch.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::export::figure::{CurveStyle, ImpactFigure, ImpactMotion, impact_figure};
/// use lindstedt::impact::{Setup, solve};
///
/// let impact = solve(Setup { stiffness: 1e6, ..Setup::default() })?;
/// let paths = impact.paths(200);
/// let styles = [("Runge-Kutta", CurveStyle::RUNGE_KUTTA), ("closed form", CurveStyle::FORMULA)];
/// let motions = paths.iter().zip(styles).map(|(path, (label, style))| {
///     ImpactMotion { label, style, samples: &path.samples, contact: &path.contact }
/// });
/// let motions: Vec<_> = motions.collect();
/// let right_barrier = Some(impact.setup.barrier);
/// let axes = ["displacement x (rad)", "time t (units of 1/ω)"];
/// let svg = impact_figure(&ImpactFigure { left_barrier: None, right_barrier, axes, motions: &motions, caption: "One impact." })?;
/// assert!(svg.starts_with("<svg") && svg.contains("closed form"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn impact_figure(data: &ImpactFigure) -> Result<String, FigureError> {
    const LEFT: &str = "left barrier";
    const RIGHT: &str = "barrier x_c";
    let motions = data.motions.iter();
    let phase: Vec<_> = motions.clone().map(|motion| phase_points(motion.samples)).collect();
    let time: Vec<_> = motions.map(|motion| time_points(motion.samples)).collect();
    let barriers = |guide: fn(f64, &'static str) -> GuideLine<'static>| {
        let left = data.left_barrier.map(|at| guide(at, LEFT));
        let right = data.right_barrier.map(|at| guide(at, RIGHT));
        left.into_iter().chain(right).collect()
    };
    let (orbits, motions) = (curves(data.motions, &phase), curves(data.motions, &time));
    let [displacement, time] = data.axes;
    let with_unit = |words: &str, axis: &str| match axis.find('(') {
        Some(unit) => format!("{words} {}", &axis[unit..]),
        None => words.to_owned(),
    };
    let enlarged = [with_unit("time since touch", time), with_unit("depth", displacement)];
    let mut panels = vec![
        panel("Phase plane", [displacement, "velocity x′"], orbits, barriers(GuideLine::X)),
        panel("Motion in time", [time, displacement], motions, barriers(GuideLine::Y)),
    ];
    let touching = data.motions.iter().filter(|motion| !motion.contact.is_empty());
    let contacts: Vec<_> = touching.map(|m| curve(m.label, m.contact, m.style)).collect();
    if !contacts.is_empty() {
        let labels = enlarged.each_ref().map(String::as_str);
        let touch =
            vec![GuideLine::Y(0.0, if data.right_barrier.is_some() { RIGHT } else { LEFT })];
        panels.push(panel("Contact, enlarged", labels, contacts, touch));
    }
    figure(&panels, data.caption)
}

/// The data of [`motion_figure`].
#[derive(Clone, Copy, Debug)]
pub struct MotionFigure<'a> {
    /// Name of the coordinate: `x`.
    pub coordinate: &'a str,
    /// Unit of the coordinate, or empty.
    pub displacement_unit: &'a str,
    /// Unit of time, or empty.
    pub time_unit: &'a str,
    /// Words for the formula in the legend: `Lindstedt-Poincaré, order 4`.
    pub formula_label: &'a str,
    /// The formula over one true period: samples (t, x, x').
    pub formula: &'a [(f64, f64, f64)],
    /// The truth, sampled at exactly the same times.
    pub truth: &'a [(f64, f64, f64)],
    /// The envelopes of a motion whose amplitude changes, times and places; none for a periodic
    /// one.
    pub envelopes: &'a [Vec<(f64, f64)>],
    /// Words below the figure, or empty.
    pub caption: &'a str,
}

/// A derived solution against Runge-Kutta: x(t), the phase plane, and the difference formula -
/// truth.
///
/// # Errors
/// [`FigureError::DifferentTimes`] where the two were not sampled at the same times; otherwise as
/// [`figure`].
///
/// ```
/// use lindstedt::export::figure::{MotionFigure, motion_figure};
/// use lindstedt::{Options, Oscillator, solve, verify::motions};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options::default())?;
/// let sampled = motions(&pendulum, &solution, &"A = 1".parse()?)?.ok_or("no real frequency")?;
/// let svg = motion_figure(&MotionFigure {
///     coordinate: "x",
///     displacement_unit: "rad",
///     time_unit: "",
///     formula_label: &solution.title(),
///     formula: &sampled.formula,
///     truth: &sampled.truth,
///     envelopes: &[],
///     caption: "A pendulum released at 1 rad.",
/// })?;
/// assert!(svg.starts_with("<svg") && svg.contains("(rad)"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn motion_figure(data: &MotionFigure) -> Result<String, FigureError> {
    let (formula, truth, name) = (data.formula, data.truth, data.coordinate);
    let same = formula.iter().zip(truth).take_while(|(f, t)| f.0 == t.0).count();
    if same < formula.len().max(truth.len()) {
        return Err(FigureError::DifferentTimes(same));
    }
    let difference: Vec<(f64, f64)> =
        formula.iter().zip(truth).map(|(f, t)| (f.0, f.1 - t.1)).collect();
    let (formula_time, truth_time) = (time_points(formula), time_points(truth));
    let (formula_phase, truth_phase) = (phase_points(formula), phase_points(truth));
    let over = |formula, truth| {
        let truth = curve("Runge-Kutta", truth, CurveStyle::RUNGE_KUTTA);
        vec![truth, curve(data.formula_label, formula, CurveStyle::FORMULA)]
    };
    let with_unit = |quantity: String, unit| match unit {
        "" => quantity,
        unit => format!("{quantity} ({unit})"),
    };
    let time = with_unit("time t".to_owned(), data.time_unit);
    let displacement = with_unit(format!("displacement {name}"), data.displacement_unit);
    let velocity = format!("velocity {name}′");
    let deviation = with_unit("formula − Runge-Kutta".to_owned(), data.displacement_unit);
    let mut motions = over(&formula_time, &truth_time);
    for (k, envelope) in data.envelopes.iter().enumerate() {
        let label = if k == 0 { "envelope of the formula" } else { "" };
        motions.push(curve(label, envelope, CurveStyle::DIFFERENCE));
    }
    let shown = match data.envelopes.is_empty() {
        true => "Motion over one true period",
        false => "Motion and its envelope",
    };
    let orbits = over(&formula_phase, &truth_phase);
    let deviations = vec![curve("", &difference, CurveStyle::DIFFERENCE)];
    let panels = [
        panel(shown, [&time, &displacement], motions, vec![]),
        panel("Phase plane", [&displacement, &velocity], orbits, vec![]),
        panel("Difference", [&time, &deviation], deviations, vec![GuideLine::Y(0.0, "")]),
    ];
    figure(&panels, data.caption)
}

/// omega against the amplitude, every method over the true motion, and below it the error on a
/// logarithmic axis. Methods with the same law share a curve, and the caption names them. `marked`
/// is the amplitude of the table.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::export::figure::backbone_figure;
/// use lindstedt::{Oscillator, verify::comparison::{backbones, compare}};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let table = compare(&pendulum, &"A = 1".parse()?, None, 0.01)?;
/// let (truth, curves) = backbones(&pendulum, &table)?;
/// let svg = backbone_figure(&truth, &curves, Some(1.0), "The pendulum.")?;
/// assert!(svg.starts_with("<svg") && svg.contains("The pendulum."));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn backbone_figure(
    truth: &Backbone,
    curves: &[Backbone],
    marked: Option<f64>,
    caption: &str,
) -> Result<String, FigureError> {
    let drawn: Vec<&Backbone> =
        curves.iter().filter(|backbone| backbone.points.len() > 1).collect();
    let mut caption = caption.to_owned();
    let label = |backbone: &&Backbone| match backbone.methods.as_slice() {
        [only] => only.clone(),
        [first, second] => format!("{first}; {second}"),
        methods => {
            caption.push_str(&format!(
                ". One law of {} methods: {}",
                methods.len(),
                methods.join("; ")
            ));
            format!("one law of {} methods", methods.len())
        }
    };
    let labels: Vec<String> = drawn.iter().map(label).collect();
    let errors: Vec<Vec<(f64, f64)>> =
        drawn.iter().map(|backbone| errors_in_percent(&backbone.points, &truth.points)).collect();
    let style = |index: usize| CurveStyle::SERIES[index % CurveStyle::SERIES.len()];
    let mut frequencies = vec![curve("true motion", &truth.points, CurveStyle::RUNGE_KUTTA)];
    let mut deviations = Vec::new();
    for (index, backbone) in drawn.iter().enumerate() {
        frequencies.push(curve(&labels[index], &backbone.points, style(index)));
        if errors[index].len() > 1 {
            deviations.push(curve(&labels[index], &errors[index], style(index)));
        }
    }
    let amplitude = "amplitude A";
    let mark = || marked.map(|at| GuideLine::X(at, "")).into_iter();
    let mut panels =
        vec![panel("Frequency", [amplitude, "frequency \u{3c9}"], frequencies, mark().collect())];
    if !deviations.is_empty() {
        let guides = mark().chain([GuideLine::Y(1.0, "")]).collect();
        let mut below = panel("Error", [amplitude, "|error| of \u{3c9} (%)"], deviations, guides);
        below.y_scale = Scale::Logarithmic;
        panels.push(below);
    }
    arranged(&panels, &caption, false)
}

/// Sets panels two abreast (a last one alone takes the row), lettered, with one legend above and
/// the caption below.
///
/// # Errors
/// [`FigureError`], which names the panel and the curve.
pub fn figure(panels: &[Panel], caption: &str) -> Result<String, FigureError> {
    arranged(panels, caption, true)
}

/// Relative difference of a curve and the truth, in per cent, at the amplitudes that both have:
/// either may begin later than the other.
fn errors_in_percent(formula: &[(f64, f64)], truth: &[(f64, f64)]) -> Vec<(f64, f64)> {
    /// Error in per cent below which the rounding of truth and formula is visible.
    const LEAST_ERROR: f64 = 1e-10;
    let error = |&(amplitude, frequency): &(f64, f64)| {
        let truth = truth.iter().find(|point| point.0 == amplitude)?.1;
        Some((amplitude, 100.0 * (frequency / truth - 1.0).abs()))
    };
    let errors = formula.iter().filter_map(error);
    errors.filter(|point| point.1 > LEAST_ERROR).collect()
}

#[cfg(not(feature = "plot"))]
fn arranged(_: &[Panel], _: &str, _: bool) -> Result<String, FigureError> {
    Err(FigureError::LeftOut)
}

fn curves<'a>(motions: &[ImpactMotion<'a>], points: &'a [Vec<(f64, f64)>]) -> Vec<Curve<'a>> {
    let pairs = motions.iter().zip(points);
    pairs.map(|(m, points)| curve(m.label, points, m.style)).collect()
}

/// A curve with words for the legend, or none.
pub(super) fn curve<'a>(label: &'a str, points: &'a [(f64, f64)], style: CurveStyle) -> Curve<'a> {
    Curve { label, points, style }
}

/// A panel with the labels of its axes, both divided evenly.
pub(super) fn panel<'a>(
    title: &'a str,
    labels: [&'a str; 2],
    curves: Vec<Curve<'a>>,
    guides: Vec<GuideLine<'a>>,
) -> Panel<'a> {
    Panel { title, x_label: labels[0], y_label: labels[1], curves, guides, ..Panel::default() }
}

fn time_points(samples: &[(f64, f64, f64)]) -> Vec<(f64, f64)> {
    samples.iter().map(|&(t, x, _)| (t, x)).collect()
}

fn phase_points(samples: &[(f64, f64, f64)]) -> Vec<(f64, f64)> {
    samples.iter().map(|&(_, x, velocity)| (x, velocity)).collect()
}

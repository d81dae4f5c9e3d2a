//! Figures to look at: curves of numbers in, one SVG text out. The drawing is kuva's; here are the
//! checks of the data, the house style, and three figures ready made, [`impact_figure`],
//! [`motion_figure`] and [`backbone_figure`].
//!
//! The same numbers give the same bytes. Colours are those of Okabe and Ito, *Color Universal
//! Design* (2008). Curves are thinned to about 2000 points; an axis whose values agree to 1e-9
//! shows a constant. A point that is not finite is an error, never a silent gap. On a logarithmic
//! axis negative values are an error, and zeros, where an error curve meets its reference, are left
//! out.
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

mod axes;

use axes::drawn;
pub(super) use axes::power_of_ten;

use crate::impact::MaterialsError;
use crate::verify::comparison::Backbone;
use kuva::prelude::{
    Figure, LabelConfig, Layout, LegendEntry, LegendPlot, Plot, SvgBackend, collect_legend_entries,
};
use kuva::render::render::{Primitive, Scene, TextAnchor};
use kuva::render::render_utils::wrap_text;

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
    /// Points of which many make a pattern.
    pub const DOTS: Self = Self("#0072b2", POINTS, 1.1);
    /// Others that do.
    pub const SECOND_MARKED_POINTS: Self = Self("#000000", POINTS, 4.5);
    /// A third kind of points that stand out.
    pub const THIRD_MARKED_POINTS: Self = Self("#009e73", POINTS, 4.5);
    /// A fourth kind.
    pub const FOURTH_MARKED_POINTS: Self = Self("#cc79a7", POINTS, 4.5);
    /// Motions that were simulated, beside the curve that they should lie on: small, light and over
    /// it.
    pub const SIMULATED: Self = Self("#56b4e9", POINTS, 3.2);
    /// Motions that do not last: in the colour of [`Self::DIFFERENCE`], dashed.
    pub const UNSTABLE: Self = Self("#0072b2", "5 3", 1.3);
    /// Free motions without damping: thin and grey.
    pub const BACKBONE: Self = Self("#777777", "none", 0.9);
    /// One of many curves, of which only the whole is to be seen.
    pub const ONE_OF_MANY: Self = Self("#bbbbbb", "none", 0.7);
    const GUIDE: Self = Self("#777777", "none", 1.0);
}

/// In place of dashes: points alone.
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

/// A thin grey line across a panel, always inside the axes, with words for the legend or none.
#[derive(Clone, Copy, Debug)]
pub enum Guide<'a> {
    /// A vertical line at a value of the abscissa.
    X(f64, &'a str),
    /// A horizontal line at a value of the ordinate.
    Y(f64, &'a str),
}

/// How an axis is divided.
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
    /// The same for the ordinate.
    pub y_label: &'a str,
    /// Division of the abscissa.
    pub x_scale: Scale,
    /// Division of the ordinate.
    pub y_scale: Scale,
    /// The curves, the last on top; at least one.
    pub curves: Vec<Curve<'a>>,
    /// Lines across the panel.
    pub guides: Vec<Guide<'a>>,
}

/// Why there is no figure.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// No panel, or a panel (named) without a curve.
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
    /// A motion that is drawn cannot be followed.
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
    /// One contact: (time since touch, depth), in the same units; empty where there is none.
    pub contact: &'a [(f64, f64)],
}

/// What [`impact_figure`] draws.
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
    let barriers = |guide: fn(f64, &'static str) -> Guide<'static>| {
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
        panel("Phase plane", [displacement, "velocity x′"], orbits, barriers(Guide::X)),
        panel("Motion in time", [time, displacement], motions, barriers(Guide::Y)),
    ];
    let touching = data.motions.iter().filter(|motion| !motion.contact.is_empty());
    let contacts: Vec<_> = touching.map(|m| curve(m.label, m.contact, m.style)).collect();
    if !contacts.is_empty() {
        let labels = enlarged.each_ref().map(String::as_str);
        let touch = vec![Guide::Y(0.0, if data.right_barrier.is_some() { RIGHT } else { LEFT })];
        panels.push(panel("Contact, enlarged", labels, contacts, touch));
    }
    figure(&panels, data.caption)
}

/// What [`motion_figure`] draws.
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
        panel("Difference", [&time, &deviation], deviations, vec![Guide::Y(0.0, "")]),
    ];
    figure(&panels, data.caption)
}

/// omega against the amplitude, every method over the true motion, and below it the error on a
/// logarithmic axis. Methods with one and the same law share a curve, and the caption names them.
/// `marked` is the amplitude of the table.
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
    let mark = || marked.map(|at| Guide::X(at, "")).into_iter();
    let mut panels =
        vec![panel("Frequency", [amplitude, "frequency \u{3c9}"], frequencies, mark().collect())];
    if !deviations.is_empty() {
        let guides = mark().chain([Guide::Y(1.0, "")]).collect();
        let mut below = panel("Error", [amplitude, "|error| of \u{3c9} (%)"], deviations, guides);
        below.y_scale = Scale::Logarithmic;
        panels.push(below);
    }
    stacked(&panels, &caption)
}

/// Width of the page in units of 1/96 inch (190 mm), and its margin.
const PAGE: f64 = 720.0;
const MARGIN: f64 = 10.0;
/// Points that are not joined, beyond which only every so many are drawn.
const MOST_DOTS: usize = 12_000;
/// Points of one curve beyond which it is thinned.
const MOST_POINTS: usize = 2000;

/// Sets panels two abreast (a last one alone takes the row), lettered, with one legend above and
/// the caption below.
///
/// # Errors
/// [`FigureError`], which names the panel and the curve.
pub fn figure(panels: &[Panel], caption: &str) -> Result<String, FigureError> {
    arranged(panels, caption, Arrangement::Abreast)
}

/// How far a curve is from the truth, in per cent, at the amplitudes that both have: either may
/// begin later than the other.
fn errors_in_percent(formula: &[(f64, f64)], truth: &[(f64, f64)]) -> Vec<(f64, f64)> {
    /// Errors in per cent below which rounding of truth and formula shows.
    const LEAST_ERROR: f64 = 1e-10;
    let error = |&(amplitude, frequency): &(f64, f64)| {
        let truth = truth.iter().find(|point| point.0 == amplitude)?.1;
        Some((amplitude, 100.0 * (frequency / truth - 1.0).abs()))
    };
    let errors = formula.iter().filter_map(error);
    errors.filter(|point| point.1 > LEAST_ERROR).collect()
}

/// Sets panels one below the other, each across the page.
fn stacked(panels: &[Panel], caption: &str) -> Result<String, FigureError> {
    arranged(panels, caption, Arrangement::Stacked)
}

#[derive(Clone, Copy, PartialEq)]
enum Arrangement {
    Abreast,
    Stacked,
}

fn arranged(
    panels: &[Panel],
    caption: &str,
    arrangement: Arrangement,
) -> Result<String, FigureError> {
    let abreast = arrangement == Arrangement::Abreast;
    if panels.is_empty() {
        return Err(FigureError::Empty("the figure".to_owned()));
    }
    let (mut plots, mut layouts, mut cells) = (Vec::new(), Vec::new(), Vec::new());
    let mut entries: Vec<LegendEntry> = Vec::new();
    for (index, panel) in panels.iter().enumerate() {
        let alone = !abreast || (index + 1 == panels.len() && index % 2 == 0);
        let columns = 1 + usize::from(alone);
        let (lines, layout) = drawn(panel, columns)?;
        let key = |entry: &LegendEntry| {
            (entry.label.clone(), entry.color.clone(), entry.dasharray.clone())
        };
        for entry in collect_legend_entries(&lines) {
            if entries.iter().all(|other| key(other) != key(&entry)) {
                entries.push(entry);
            }
        }
        plots.push(lines);
        layouts.push(layout);
        // Cells 0 and 1 are the row of the legend.
        let first = if abreast { index + 2 } else { 2 * index + 2 };
        cells.push((first..first + columns).collect());
    }
    entries.sort_by_key(|entry| entry.color == CurveStyle::GUIDE.0);
    let longest = entries.iter().map(|entry| entry.label.chars().count()).max();
    let rows = if abreast { panels.len().div_ceil(2) } else { panels.len() };
    let abreast = (97 / (longest.unwrap_or(0) + 7)).clamp(1, 4);
    let legend_height = 1.0 + 22.0 * entries.len().div_ceil(abreast) as f64;
    let legend = LegendPlot::from_entries(entries).with_cols(abreast).with_max_cols(abreast);
    plots.push(vec![Plot::LegendPlot(legend.without_box())]);
    // A small font at a large scale: longer samples of the lines beside text of the usual size.
    let layout = Layout::new((0.0, 1.0), (0.0, 1.0)).with_scale(1.5).with_body_size(8);
    layouts.push(layout.with_force_margins(16.0, 0.0).with_force_margins_y(6.0, 0.0));
    cells.push(vec![0, 1]);

    let letters: Vec<String> = ('A'..='Z').take(panels.len()).map(String::from).collect();
    let scene = Figure::new(1 + rows, 2)
        .with_structure(cells)
        .with_plots(plots)
        .with_layouts(layouts)
        .with_labels_custom(letters.iter().map(String::as_str).collect(), LabelConfig::default())
        .with_padding(MARGIN)
        .with_cell_size((PAGE - 2.0 * MARGIN - 15.0) / 2.0, 290.0)
        .with_row_height(0, legend_height)
        .render();
    Ok(written(scene, caption))
}

fn curves<'a>(motions: &[ImpactMotion<'a>], points: &'a [Vec<(f64, f64)>]) -> Vec<Curve<'a>> {
    let pairs = motions.iter().zip(points);
    pairs.map(|(m, points)| curve(m.label, points, m.style)).collect()
}

fn curve<'a>(label: &'a str, points: &'a [(f64, f64)], style: CurveStyle) -> Curve<'a> {
    Curve { label, points, style }
}

fn panel<'a>(
    title: &'a str,
    labels: [&'a str; 2],
    curves: Vec<Curve<'a>>,
    guides: Vec<Guide<'a>>,
) -> Panel<'a> {
    Panel { title, x_label: labels[0], y_label: labels[1], curves, guides, ..Panel::default() }
}

fn time_points(samples: &[(f64, f64, f64)]) -> Vec<(f64, f64)> {
    samples.iter().map(|&(t, x, _)| (t, x)).collect()
}

fn phase_points(samples: &[(f64, f64, f64)]) -> Vec<(f64, f64)> {
    samples.iter().map(|&(_, x, velocity)| (x, velocity)).collect()
}

/// Words as they stand: the library reads `$...$` as mathematics, and XML has no control
/// characters.
fn printable(text: &str) -> String {
    text.replace('$', "\\$")
        .replace(|c: char| c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}'), " ")
}

/// The scene and its caption as SVG, without the library's version, and with the clip regions,
/// which the library counts through the life of the process, numbered from 0.
pub(super) fn written(mut scene: Scene, caption: &str) -> String {
    // SVG runs ordinary spaces together.
    let mut lines = wrap_text(&printable(caption.trim()).replace("  ", " \u{a0}"), 106);
    lines.retain(|line| !line.is_empty());
    for content in lines {
        scene.height += 17.0;
        let (x, y) = (2.0 * MARGIN, scene.height - MARGIN);
        let (size, anchor) = (12, TextAnchor::Start);
        scene.add(Primitive::Text {
            x,
            y,
            content,
            size,
            anchor,
            rotate: None,
            bold: false,
            color: None,
        });
    }
    let clips = scene.elements.iter_mut().filter_map(|element| match element {
        Primitive::ClipStart { id, .. } => Some(id),
        _ => None,
    });
    for (number, id) in clips.enumerate() {
        let (old, new) = (format!("\"{id}\""), format!("clip-{number}"));
        for region in &mut scene.defs {
            *region = region.replace(&old, &format!("\"{new}\""));
        }
        *id = new;
    }
    let svg = SvgBackend::new().with_pretty(true).render_scene(&scene);
    // A mitred corner of a thick line sticks out: a graze would seem to go far into the barrier.
    svg.replacen("<svg ", "<svg stroke-linejoin=\"round\" ", 1).replacen(
        &format!("  <!-- Generated by kuva {} -->\n", kuva::VERSION),
        "",
        1,
    )
}

#[cfg(test)]
mod tests {
    use super::axes::thinned;
    use super::*;

    const WAVE: [(f64, f64); 4] = [(0.0, 0.0), (1.0, 2.0), (2.0, -1.0), (3.0, 0.5)];

    fn one(
        y_scale: Scale,
        label: &str,
        points: &[(f64, f64)],
        guides: Vec<Guide>,
    ) -> Result<String, FigureError> {
        let curves = vec![curve(label, points, CurveStyle::FORMULA)];
        let panel = panel("T", ["x (s)", "y (rad)"], curves, guides);
        figure(&[Panel { y_scale, ..panel }], "<svg>")
    }

    /// What is drawn in the style of [`one`].
    fn path(svg: &str) -> Vec<&str> {
        let drawn = |line: &&str| line.contains("<path") && line.contains(CurveStyle::FORMULA.0);
        svg.lines().filter(drawn).collect()
    }

    fn impact() -> String {
        let samples: Vec<_> =
            (0..50).map(|i| f64::from(i) / 8.0).map(|t| (t, t.cos(), -t.sin())).collect();
        let motions = [("Runge-Kutta", CurveStyle::RUNGE_KUTTA), ("paper", CurveStyle::FORMULA)];
        let motion =
            |(label, style)| ImpactMotion { label, style, samples: &samples, contact: &WAVE };
        let (motions, right_barrier) = (&motions.map(motion), Some(0.3));
        impact_figure(&ImpactFigure {
            left_barrier: None,
            right_barrier,
            axes: ["displacement x (rad)", "time t (units of 1/ω)"],
            motions,
            caption: "End.",
        })
        .unwrap()
    }

    #[test]
    fn three_lettered_panels_share_one_legend_and_the_truth_lies_below() {
        let svg = impact();
        for words in
            ["A", "B", "C", "Contact, enlarged", "Runge-Kutta", "paper", "barrier x_c", "End."]
        {
            assert_eq!(svg.matches(&format!(">{words}</text>")).count(), 1, "{words}");
        }
        assert_eq!((svg.matches("<clipPath").count(), svg.matches("<path").count()), (3, 9));
        assert!(
            svg.find(CurveStyle::RUNGE_KUTTA.0).unwrap() < svg.find(CurveStyle::FORMULA.0).unwrap()
        );
    }

    #[test]
    fn the_same_numbers_give_the_same_bytes_and_no_version() {
        let first = impact();
        assert_eq!(first, impact());
        assert!(first.contains("url(#clip-2)") && !first.contains("kuva"));
    }

    #[test]
    fn an_error_is_that_at_its_amplitude_wherever_the_curves_begin() {
        let truth = [(1.0, 1.0), (2.0, 2.0), (3.0, 4.0), (4.0, 8.0)];
        let late = [(3.0, 2.0), (4.0, 8.0), (5.0, 9.0)];
        assert_eq!(errors_in_percent(&late, &truth), [(3.0, 50.0)]);
        assert_eq!(errors_in_percent(&truth, &late), [(3.0, 100.0)]);
    }

    #[test]
    fn words_stand_as_they_are() {
        let svg = one(Scale::Linear, "a < b & $x^2$ \u{1}", &WAVE, vec![]).unwrap();
        assert!(
            svg.contains(">a &lt; b &amp; $x^2$ ")
                && svg.contains(">&lt;svg&gt;<")
                && !svg.contains('\u{1}')
        );
    }

    #[test]
    fn a_power_of_ten_moves_from_the_numbers_to_the_label() {
        let draw = |factor: f64| {
            one(Scale::Linear, "", &WAVE.map(|(x, y)| (x, y * factor)), vec![]).unwrap()
        };
        assert_eq!((path(&draw(1.0)).len(), path(&draw(1e-7))), (1, path(&draw(1.0))));
        assert!(draw(1e-7).contains(">y (10⁻⁷ rad)<") && draw(1.0).contains(">y (rad)<"));
        assert!(!draw(1e-310).contains("NaN") && !draw(8e307).contains("inf"));
    }

    #[test]
    fn a_logarithmic_ordinate_reaches_small_errors_and_skips_zeros() {
        let errors = [(1.0, 0.0), (1.0, 1e-18), (2.0, 1e-14), (3.0, 1e-10)];
        let draw = |points| one(Scale::Logarithmic, "e", points, vec![]);
        let svg = draw(&errors).unwrap();
        assert!(svg.contains(">10⁻¹⁸<") && svg.contains(">10⁻¹²<"));
        assert_eq!(path(&svg), path(&draw(&errors[1..]).unwrap()));
        assert!(matches!(draw(&errors[..2]), Err(FigureError::TooFewPoints(_))));
        let refused = draw(&[(0.0, 1.0), (1.0, -0.5)]).unwrap_err().to_string();
        assert!(refused.starts_with("point (1.0, -0.5) of \"e\" in panel \"T\""), "{refused}");
    }

    #[test]
    fn a_logarithmic_abscissa_has_decades() {
        let points = [(1e4, 1.0), (1e6, 2.0), (1e9, 3.0)];
        let curves = vec![curve("", &points, CurveStyle::FORMULA)];
        let panel = panel("T", ["stiffness", "y"], curves, vec![Guide::X(1e5, "")]);
        let draw = |x_scale| figure(&[Panel { x_scale, ..panel.clone() }], "").unwrap();
        let svg = draw(Scale::Logarithmic);
        assert!(["10⁴", "10⁹"].iter().all(|tick| svg.contains(&format!(">{tick}<"))), "{svg}");
        assert_ne!(path(&svg), path(&draw(Scale::Linear)));
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert!(matches!(figure(&[], ""), Err(FigureError::Empty(_))));
        assert!(matches!(figure(&[Panel::default()], ""), Err(FigureError::Empty(_))));
        assert!(matches!(
            one(Scale::Linear, "", &WAVE[..1], vec![]),
            Err(FigureError::TooFewPoints(_))
        ));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for points in [[WAVE[0], (bad, 0.0)], [(0.0, bad), WAVE[1]]] {
                assert!(matches!(
                    one(Scale::Linear, "", &points, vec![]),
                    Err(FigureError::OffAxes(_))
                ));
            }
            let guides = vec![Guide::X(bad, "g")];
            assert!(matches!(one(Scale::Linear, "", &WAVE, guides), Err(FigureError::OffAxes(_))));
        }
        let [formula, truth] = [1.0, 1.1].map(|end| vec![(0.0, 1.0, 0.0), (end, 0.5, 0.2)]);
        let draw = |formula, truth| {
            let [coordinate, displacement_unit, time_unit, formula_label, caption] =
                ["x", "rad", "s", "f", ""];
            motion_figure(&MotionFigure {
                coordinate,
                displacement_unit,
                time_unit,
                formula_label,
                formula,
                truth,
                envelopes: &[],
                caption,
            })
        };
        assert_eq!(draw(&formula, &truth), Err(FigureError::DifferentTimes(1)));
        assert!(draw(&truth, &truth).unwrap().contains(">formula − Runge-Kutta (rad)<"));
    }

    #[test]
    fn thinning_keeps_every_peak() {
        let mut points: Vec<_> =
            (0..100_000).map(f64::from).map(|x| (x, (x / 5e3).sin())).collect();
        points[77_777].1 = 9.0;
        let kept = thinned(&points);
        assert!(kept.len() <= MOST_POINTS + 1 && kept.contains(&points[77_777]));
        assert_eq!((kept.first(), kept.last()), (points.first(), points.last()));
    }
}
